"""python3 lessons.py [--short] [NAME ...]: the scenes of the twelve lessons (../01_bounce.c to ../12_effects.c) in Python.

Prints what the C programs print: tests/python/check.py compares both digit for digit. The questions, the theory and the
exercises are in the C files; the first function below, `bounce`, shows the same scene line by line. --short runs a part
of each lesson. Three things stay in C: the exam of a law (examples/exam.h is a C header), times of steps (they differ
from run to run) and the trials with --short (they need 10 s)."""
import math
import sys

import dem

pi, g = 3.14159265, 9.81


def mean(values):
    """The mean of independent values and its standard error."""
    n = len(values)
    total = 0.0
    for value in values:
        total += value
    squares = 0.0
    for value in values:
        squares += (value - total/n)*(value - total/n)
    return total/n, math.sqrt(squares/(n - 1)/n) if n > 1 else 0


def row(name, value, error=0):
    """A line as lesson_row in examples/lesson.h prints it, up to the expected value."""
    if error > 0:
        decimals = min(max(1 - math.floor(math.log10(error)), 0), 6)
        text = "%.*f +- %.*f" % (decimals, value, decimals, error)
    else:
        text = "%.4g" % value
    return ("%-46s %-18s" % (name, text)).rstrip()


def bounce(short):
    restitution, height, radius = 0.8, 0.5, 0.01                    # -, m, m
    rest = math.sqrt(2*height/g)*(1 + restitution)/(1 - restitution)
    world = dem.World(gravity=(0, 0, -g), dt=2e-6)
    glass = world.material(density=2500, young=1e9, poisson=0.23, restitution=restitution)
    world.wall_plane(glass, (0, 0, 0), (0, 0, 1))
    ball = world.sphere(glass, radius, (0, 0, radius + height))
    last_speed = last_rise = 0
    bounces = 0
    while world.time < 1.2*rest:
        # many steps at once where nothing is to be recorded: falls, rises, and the end; single steps otherwise
        if last_rise and world.time > last_rise + 0.7:
            world.step(1000)
        elif abs(last_speed) < 0.05:
            world.step(1)
        else:
            world.step(20 if last_speed < 0 else int((last_speed - 0.04)/g/2e-6))
        state = ball.state
        speed = state.velocity.z
        if last_speed > 0 and speed <= 0 and bounces < 5:
            bounces += 1
            yield row("height of rebound %d [m]" % bounces, state.position.z - radius)
            if short and bounces == 3:
                return
        if speed > 0.02:
            last_rise = world.time
        last_speed = speed
    yield row("time until the ball lies still [s]", last_rise)


def yard(friction, rolling):
    world = dem.World(planar=1, thickness=0.01, gravity=(0, -g, 0))
    wood = world.material(density=700, young=1.5e7, poisson=0.3, restitution=0.3, friction=friction, rolling_friction=rolling)
    world.wall_plane(wood, (0, 0, 0), (0, 1, 0))
    return world, wood


def pile(short):
    overlaps = []

    def slope(rolling, seed):
        R, half = 0.005, 0.03
        world, wood = yard(0.5, rolling)
        column = world.wall_profile(wood, dem.Profile(vertices=[(-half, 0), (-half, 0.23), (half, 0), (half, 0.23)],
                                                      segments=[(0, 1), (2, 3)]))
        for i in range(2):
            world.spheres_fill(wood, 0.8*R if i else R, (-half, 0, 0, half, 0.22, 0), 55, 2*seed + i)
        column.motion_set(kind="translating", velocity=(0, 0.4, 0), start=0.25)
        for _ in range(60):
            world.run(0.02)
        height = distance = 0
        for x, y, _, _ in world.bodies.positions.tolist():
            height += y - R
            distance += abs(x)
        overlaps.append(world.counters.overlap_max)
        return math.atan(height/distance)*180/3.14159265

    def stands(friction):
        R = 0.05
        world, wood = yard(friction, 0)
        world.sphere(wood, R, (-R, R, 0))
        world.sphere(wood, R, (R, R, 0))
        upper = world.sphere(wood, R, (0, R + math.sqrt(3.0)*R, 0))
        world.run(1)
        return upper.state.position.y > 2.5*R

    for rolling in (() if short else (0, 0.1, 0.5)):
        yield row("slope, rolling friction %g [degrees]" % rolling, *mean([slope(rolling, seed) for seed in (1, 2, 3)]))
    low, high = 0.1, 0.5
    while high - low > 0.002:
        if stands((low + high)/2):
            high = (low + high)/2
        else:
            low = (low + high)/2
    yield row("smallest mu that holds three logs", (low + high)/2, (high - low)/2)
    if not short:
        yield row("largest overlap [radii]", max(overlaps))


def incline(short):
    mu, radius, k = 0.2, 0.01, 2/5.0
    for angle in range(10, 51, 10):
        s, c = math.sin(angle*math.pi/180), math.cos(angle*math.pi/180)
        world = dem.World(gravity=(g*s, 0, -g*c), orientations=1)
        steel = world.material(density=7800, young=1e9, poisson=0.3, restitution=0.3, friction=mu)
        world.wall_plane(steel, (0, 0, 0), (0, 0, 1))
        ball = world.sphere(steel, radius, (0, 0, radius))
        for i in range(60):
            world.run(0.01)
            state = ball.state
            speed, turning = state.velocity.x, radius*state.spin.y
            if i == 9:
                first_speed, first_turning, start = speed, turning, world.time
        time = world.time - start
        rolls = s/c <= (1 + 1/k)*mu
        yield row("%d degrees, %s: a [m/s2]" % (angle, "rolls" if rolls else "slides"), (speed - first_speed)/time)
        yield row("                    R dw/dt [m/s2]", (turning - first_turning)/time)


def own_law(short):
    k1 = 1e4
    for ratio in (1, 2, 4, 10):
        for speed in (0.1, 1):
            k2 = ratio*k1

            def hysteretic(c, memory, force):
                most = max(memory[0], c.overlap)
                loading = k1*c.overlap
                unloading = k2*(c.overlap - (1 - k1/k2)*most)
                force.normal = max(min(unloading, loading), 0)
                if c.dt > 0:
                    memory[0] = most
            radius = 0.005
            world = dem.World(law=hysteretic, law_memory=1, law_stiffness=k2)
            clay = world.material(density=2000, young=1e7, restitution=1)
            pair = [world.sphere(clay, radius, ((2*i - 1)*1.01*radius, 0, 0)) for i in range(2)]
            for i in range(2):
                pair[i].set(velocity=((1 - 2*i)*speed/2, 0, 0))
            for _ in range(100):
                world.run((0.1*radius/speed + 5e-3)/100)
            yield row("restitution, k2 = %.0f k1, %.1f m/s" % (ratio, speed), 2*pair[1].state.velocity.x/speed)


def silo(short):
    R, D, mu = 2e-3, 24e-3, 0.4
    overlaps = []

    def janssen(rho_b, K, H):
        lamb = D/(4*mu*K)
        return rho_b*g*pi*D*D/4*lamb*(1 - math.exp(-H/lamb))

    def fill(count, seed):
        world = dem.World(gravity=(0, 0, -g))
        glass = world.material(density=2500, young=6e6, poisson=0.25, restitution=0.3, friction=mu)
        floor = world.wall_plane(glass, (0, 0, 0), (0, 0, 1))
        tube = world.wall_cylinder(glass, (0, 0, 0), (0, 0, 1), D/2, 1)
        tube.motion_set(kind="translating", velocity=(0, 0, 0.01))
        world.spheres_fill(glass, R, (-D/2, -D/2, 0, D/2, D/2, 0.006 + count*3e-4), count, seed)
        for i in range(70):
            if i == 50:
                floor.loads_reset()
                tube.loads_reset()
                world.overlap_max_reset()
            world.run(0.005)
        below, totals = floor.loads, world.totals
        overlaps.append(world.counters.overlap_max)
        return 2*totals.centre[2], -below.impulse[2]/below.time, g*totals.mass

    heights, weights, loads = [], [], []
    for count in ((75,) if short else (75, 150, 300, 450)):
        runs = [fill(count, seed) for seed in (1, 2, 3)]
        heights.append(sum(run[0]/3.0 for run in runs))
        weights.append(sum(run[2]/3.0 for run in runs))
        loads.append(mean([run[1] for run in runs]))
        yield row("H/D %.2f, weight %.4f N: floor [N]" % (heights[-1]/D, weights[-1]), *loads[-1])
    if short:
        return
    rho_b = weights[-1]/(g*pi*D*D/4*heights[-1])
    K, least, k = 0, 1e300, 0.1
    while k < 1.5:
        total = sum(pow(load[0] - janssen(rho_b, k, height), 2) for load, height in zip(loads, heights))
        if total < least:
            least, K = total, k
        k += 0.001
    yield row("K, horizontal over vertical pressure", K)
    yield row("load on the floor over weight, highest column", loads[-1][0]/weights[-1])
    yield row("largest overlap [radii]", max(overlaps))


def hopper(short):
    R, x, thickness, count = 2.5e-3, 0.045, 5e-3, 480
    d, k, overlaps = 2*R, 1.4, []

    def run_out(hole, seed):
        world = dem.World(planar=1, thickness=thickness, gravity=(0, -g, 0), dt=1.4e-5)
        bead = world.material(density=2500, young=2.5e7, poisson=0.25, restitution=0.5, friction=0.4)
        b = hole/2
        corners = [(-x, 0.25), (-x, 0), (-b, 0), (b, 0), (x, 0), (x, 0.25)]
        world.wall_profile(bead, dem.Profile(vertices=corners, segments=[(0, 1), (1, 2), (3, 4), (4, 5)]))
        closed = world.wall_profile(bead, dem.Profile(vertices=corners, segments=[(2, 3)]))
        for i in range(2):
            world.spheres_fill(bead, (0.95 + 0.1*i)*R, (-x, 0, 0, x, 0.24, 0), count//2, 2*seed + i)
        out = world.outlet(box=(-x, -0.2, -1, x, -0.02, 1))
        world.run(0.3)
        full = world.totals
        bulk = full.mass/(4*x*full.centre[1])/thickness
        closed.remove()
        world.overlap_max_reset()
        begun, mark, mass = world.time, [], []
        while len(mark) < 4 and world.time < begun + 5:
            world.run(0.01)
            gone = out.state
            if gone.total >= count*(1 + 2*len(mark))//10:
                mark.append(world.time)
                mass.append(gone.total_mass)
        overlaps.append(world.counters.overlap_max)
        return ((mass[2] - mass[0])/(mark[2] - mark[0]),
                (mass[3] - mass[2])/(mark[3] - mark[2])/((mass[1] - mass[0])/(mark[1] - mark[0])), bulk)

    holes = (6*d, 7.5*d, 9*d)
    rate, error, C, even = [], [], [], []
    for hole in holes[2:] if short else holes:
        runs = [run_out(hole, seed) for seed in (1, 2)]
        rho_b = sum(run[2]/2.0 for run in runs)
        even += [run[1] for run in runs]
        m, e = mean([run[0] for run in runs])
        rate.append(m)
        error.append(e)
        C.append(m/(rho_b*thickness*math.sqrt(g)*pow(hole - k*d, 1.5)))
        yield "%6.1f  %8.4f +- %.4f  %8.2f  %8.2f" % (hole/d, m, e, C[-1], mean(even[-2:])[0])
    if short:
        return
    span = math.log((holes[2] - k*d)/(holes[0] - k*d))
    yield row("exponent of (B - 1.4 d)", math.log(rate[2]/rate[0])/span, math.hypot(error[0]/rate[0], error[2]/rate[2])/span)
    yield row("C, mean of the three holes", *mean(C))
    yield row("flow when half empty over flow when full", *mean(even))
    yield row("largest overlap [radii]", max(overlaps))


def brazil_nut(short):
    r, big, half = 2e-3, 7e-3, 0.022
    rises, borne, overlaps = [], [], []

    def shake(gamma, frequency, periods, seed):
        world = dem.World(planar=1, thickness=4e-3, gravity=(0, -g, 0), dt=7e-6)
        bead = world.material(density=2500, young=5e7, poisson=0.25, restitution=0.5, friction=0.4)
        box = world.wall_profile(bead, dem.Profile(vertices=[(-half, 0.16), (-half, 0), (half, 0), (half, 0.16)],
                                                   segments=[(0, 1), (1, 2), (2, 3)]))
        nut = world.sphere(bead, big, (0, 1.01*big, 0))
        for i in range(2):
            world.spheres_fill(bead, (0.95 + 0.15*i)*r, (-half, 0, 0, half, 0.11, 0), 65, 2*seed + i)
        world.run(0.25)
        box.motion_set(kind="oscillating", velocity=(0, 1, 0), frequency=frequency,
                       amplitude=gamma*g/pow(2*pi*frequency, 2))
        box.loads_reset()
        world.overlap_max_reset()
        start = nut.state.position.y
        line = "Gamma = %.1f, filling %d, rise every 6 periods [small diameters]:" % (gamma, seed)
        for i in range(periods):
            for _ in range(5):
                world.run(0.2/frequency)
            rise = (nut.state.position.y - start)/(2*r)
            if i % 6 == 5:
                line += " %.1f" % rise
        loads, after = box.loads, world.totals
        rises.append(rise)
        borne.append((-loads.impulse[1] - after.momentum[1])/loads.time/(g*after.mass))
        overlaps.append(world.counters.overlap_max)
        return line

    yield shake(0.8, 12, 12, 1)
    if not short:
        for seed in (1, 2, 3):
            yield shake(3, 10, 36, seed)
    yield row("rise at Gamma = 0.8 [small diameters]", rises[0])
    yield row("mean force over weight, Gamma = 0.8", borne[0])
    if not short:
        yield row("rise at Gamma = 3 [small diameters]", *mean(rises[1:]))
        yield row("mean force over weight, Gamma = 3", mean(borne[1:])[0])
        yield row("largest overlap, at the large disc [radii]", max(overlaps[1:]))


def drum(short):
    R, r, sides, frames, late = 0.04, 1.5e-3, 24, 80, 30
    turned = []
    for froude in (0.01,) if short else (0.01, 0.05, 0.3, 3):
        world = dem.World(planar=1, thickness=3e-3, gravity=(0, -g, 0), dt=8e-6)
        bead = world.material(density=2500, young=1.5e7, poisson=0.25, restitution=0.5, friction=0.5, rolling_friction=0.05)
        corners, segments = [], []
        for i in range(2*sides):
            angle = pi*(i - i % 2)/sides
            corners.append(((R - r*(i % 2))*math.cos(angle), (R - r*(i % 2))*math.sin(angle)))
            segments.append((i - i % 2, i if i % 2 else (i + 2) % (2*sides)))
        shell = world.wall_profile(bead, dem.Profile(vertices=corners, segments=segments))
        shell.motion_set(kind="rotating", axis=(0, 0, 1), speed=math.sqrt(froude*g/R))
        world.spheres_fill(bead, r, (-0.03, -0.024, 0, 0.03, 0.024, 0), 160, 1)
        centre, above = [0, 0], 0
        for i in range(frames):
            if i == late:
                shell.loads_reset()
                world.overlap_max_reset()
            world.run(0.02)
            if i < late:
                continue
            grains, totals = world.bodies, world.totals
            above += sum(grains.positions[k, 1] > 0 for k in range(grains.count))
            for k in range(2):
                centre[k] += totals.centre[k]/(frames - late)
        loads = shell.loads
        angle = math.atan2(centre[0], -centre[1])*180/pi
        turned.append((froude, loads.torque_impulse/loads.time, world.totals.mass*g*centre[0], angle,
                       above/grains.count/(frames - late), world.counters.overlap_max))
        yield "Fr = %.2f: centre of mass at %3.0f degrees from the vertical" % (froude, angle)
    for froude, torque, lever, angle, above, overlap in turned[:3]:
        yield row("torque at Fr = %.2f, and M g x [mN m]" % froude, -1e3*torque)
    yield row("slope at Fr = 0.01 [degrees]", turned[0][3])
    if not short:
        yield row("steeper at Fr = 0.3 by [degrees]", turned[2][3] - turned[0][3])
    yield row("fraction above the axis, Fr = 0.01", turned[0][4])
    if not short:
        yield row("fraction above the axis, Fr = 3", turned[3][4])
        yield row("largest overlap, at a lip [radii]", max(t[5] for t in turned))


def moving_wall(short):
    V, mu, radius = 1, 0.3, 0.01
    belt = "solid belt\n"
    for i in range(24):
        x, upper = 50*(i//2) - 500, i % 2
        belt += ("facet normal 0 0 1\n outer loop\n  vertex %d %d 0\n  vertex %d %d 0\n  vertex %d 25 0\n endloop\nendfacet\n"
                 % (x, 25 if upper else -25, x + 50, -25, x + (50 if upper else 0)))
    worlds, walls, balls = [], [], []
    for i in range(2):
        world = dem.World(gravity=(0, 0, -g), ledger=1, orientations=1)
        rubber = world.material(density=1200, young=1e8, poisson=0.45, restitution=0.3, friction=mu)
        if i == 0:
            mesh, health = world.mesh_parse("belt.stl", belt + "endsolid belt\n")
            yield "belt.stl: %d triangles, %d open edges, %d slivers. %s" % (mesh.triangle_count, health.open_edges,
                                                                            health.slivers, health.hint)
            world.mesh_place(mesh, 1e-3, (1, 0, 0, 0), (0, 0.003, 0))
            wall = world.wall_mesh(rubber, mesh)
        else:
            wall = world.wall_plane(rubber, (0, 0, 0), (0, 0, 1))
        wall.motion_set(kind="translating", velocity=(V, 0, 0))
        worlds.append(world)
        walls.append(wall)
        balls.append(world.sphere(rubber, radius, (0, 0, radius)))
    apart = 0
    for i in range(1, 61):
        for world in worlds:
            world.run(0.0025)
        state, other = balls[0].state, balls[1].state
        apart = max(apart, math.hypot(state.position.x - other.position.x, state.position.z - other.position.z))
        t = worlds[0].time
        if i % 10 == 0:
            yield "%8.3f  %11.4f  %14.4f" % (t, state.velocity.x, min(mu*g*t, 2*V/7.0))
    ledger = worlds[0].ledger
    yield row("final speed [m/s]", state.velocity.x)
    yield row("final -R w [m/s]", -radius*state.spin.y)
    yield row("work of the belt [mJ]", 1e3*walls[0].loads.work)
    yield row("heat of sliding [mJ]", 1e3*(ledger.slide + ledger.tangent))
    yield row("residual of the ledger over energy supplied", abs(ledger.residual)/ledger.throughput)
    yield row("distance of paths on mesh and plane [m]", apart)
    yield row("open edges of the mesh", health.open_edges)


def clusters(short):
    r, count = 1e-3, 80
    inertia, overlaps, means = [], [], []

    def heap(tetrahedra, seed):
        world = dem.World(gravity=(0, 0, -9.81), normal_law="linear")
        gravel = world.material(density=2500, stiffness=1200, restitution=0.3, friction=0.5,
                                rolling_friction=0 if tetrahedra else 0.05)
        world.wall_plane(gravel, (0, 0, 0), (0, 0, 1))
        tube = world.wall_cylinder(gravel, (0, 0, 0), (0, 0, 1), 0.012, 1)
        inside = dem.Region(box=(-0.012, -0.012, 0, 0.012, 0.012, 0.045), cylinder="z")
        if tetrahedra:
            a = r/math.sqrt(2.0)
            shape = world.shape_cluster(positions=[(a, a, a), (a, -a, -a), (-a, a, -a), (-a, -a, a)], radius=r)
            world.bodies_fill(gravel, shape, inside, count, seed)
            info = shape.info
            inertia.append(info.inertia.z/(info.volume*r*r))
        else:
            world.spheres_fill(gravel, CUBE_ROOT_4*r, inside, count, seed)
        for i in range(55):
            if i == 20:
                tube.remove()
            world.run(0.01)
        high = far = 0
        for x, y, z, _ in world.bodies.positions.tolist():
            high += z - CUBE_ROOT_4*r
            far += math.hypot(x, y)
        overlaps.append(world.counters.overlap_max)
        return math.atan(4*high/(2*far))*180/pi

    for kind in (0,) if short else (0, 1):
        means.append(mean([heap(kind, seed) for seed in (1, 2)]))
    if inertia:
        yield row("I/(M r^2) of a tetrahedron", inertia[-1])
    yield row("slope of balls [degrees]", *means[0])
    if not short:
        yield row("slope of tetrahedra [degrees]", *means[1])
        yield row("largest overlap [radii]", max(overlaps))


CUBE_ROOT_4 = math.cbrt(4.0) if hasattr(math, "cbrt") else 1.5874010519681996      # of the C library: Python 3.11 has it


def advise(short):
    speed = 5
    world = dem.World(planar=1, thickness=4e-3, gravity=(0, -g, 0), threads=1)
    glass = world.material(density=2500, young=2e7, poisson=0.25, restitution=0.6, friction=0.4)
    drum = world.wall_cylinder(glass, (0, 0, 0), (0, 0, 1), 0.05, 1)
    drum.motion_set(kind="rotating", axis=(0, 0, 1), speed=speed)
    world.spheres_fill(glass, 2e-3, (-0.035, -0.035, 0, 0.035, 0.015, 0), 150, 1)
    for i in range(50):
        if i == 25:
            drum.loads_reset()
        world.run(0.02)

    def power(world):                                               # also of the copies that the trials run
        loads = drum.of(world).loads
        return loads.work/loads.time

    direct = power(world)
    if not short:
        drum.loads_reset()
        trials = world.trials_run(duration=1, budget=10, tolerance=0.1, observables=[
            dem.Observable(name="power", unit="W", function=power)])
        softer = [t.dt for t in trials.trial[:trials.count] if 0.99 < t.step < 1.01 and t.stiffness < 0.11][-1]
        yield row("factor on the step if 10 times softer", softer/trials.trial[0].dt)
    yield row("power, and w M g x [mW]", 1e3*direct)


def effects(short):
    beads = 400

    def air(position, velocity, radius, mass, time):
        drag = (-6*3.1416*1.8e-5)*radius
        return drag*velocity.x, drag*velocity.y, drag*velocity.z

    def bed(things):
        box = (0, 0, 0, 0.011, 0.011, 0.05)
        world = dem.World(gravity=(0, 0, -9.81), boundary=("periodic", "periodic", "open"), domain=box, threads=1,
                          ledger=things >= 4, force=air if things >= 5 else None)
        glass = world.material(density=2500, young=5e6, poisson=0.25, restitution=0.5, friction=0.4 if things >= 1 else 0,
                               rolling_friction=0.05 if things >= 2 else 0)
        world.wall_plane(glass, (0, 0, 0), (0, 0, 1))
        world.spheres_fill(glass, 0.8e-3 if things >= 3 else 1e-3, box, beads//2, 1)
        world.spheres_fill(glass, 1e-3, box, beads//2, 2)
        for _ in range(140):
            world.run(0.002)
        world.step(900)
        return world

    names = ("smooth beads, all alike", "friction", "rolling friction", "two sizes", "ledger of energy", "user-defined force field")
    contacts = []
    for things in range(1 if short else 6):
        contacts.append(bed(things).counters.contacts/beads)
        yield "%s %-26s%s%20.2f" % ("+" if things else " ", names[things], "...", contacts[-1])
    yield row("contacts per bead, smooth", contacts[0])
    if not short:
        yield row("contacts per bead, with friction", contacts[1])


LESSONS = {"01_bounce": bounce, "02_pile": pile, "03_incline": incline, "04_own_law": own_law, "05_silo": silo,
           "06_hopper": hopper, "07_brazil_nut": brazil_nut, "08_drum": drum, "09_moving_wall": moving_wall,
           "10_clusters": clusters, "11_advise": advise, "12_effects": effects}

if __name__ == "__main__":
    names = [name for name in sys.argv[1:] if name != "--short"] or list(LESSONS)
    for name in names:
        if name not in LESSONS:
            sys.exit("lessons.py: %s is no lesson; there are %s" % (name, ", ".join(LESSONS)))
        for line in LESSONS[name]("--short" in sys.argv):
            print(line, flush=True)
