"""python3 overhead.py [PAGE]: what Python costs: calls, functions per step and per contact, beside the same in C.

Prints lines `name = value unit`. With PAGE (docs/python.md) it also writes them into the page, between the markers of the
block `overhead`. A C library of a law, a force field and a loop over steps is compiled for comparison. Times are
processor times of this thread, the smallest of five rounds."""
import ctypes
import os
import platform
import re
import subprocess
import sys
import tempfile
import time

import dem

C = """
#include "dem.h"
void law(const dem_contact *c, dem_real *memory, dem_contact_force *force) {
    (void)memory;
    force->normal = 1e3*c->overlap + 0.3*c->closing_speed;
}
void lift(const dem_body_state *body, dem_body id, double time, dem_vec3 *force, dem_vec3 *torque, void *user) {
    (void)id; (void)time; (void)torque; (void)user;
    force->z = 0.1*body->mass;
}
void move(double time, dem_pose *pose, void *user) { (void)user; pose->velocity.x = 0; pose->position.x = 0*time; }
int watch(dem_world *world, int64_t number, void *user) { (void)world; (void)number; (void)user; return 0; }
int loop(dem_result (*step)(dem_world *, int), void *world, int steps) {
    int i;
    for (i = 0; i < steps; i++) if (step((dem_world *)world, 1) != DEM_OK) return 1;
    return 0;
}
"""


def law(c, memory, force):
    force.normal = 1e3*c.overlap + 0.3*c.closing_speed


def lift(body, id, time, force, torque):
    force.z = 0.1*body.mass


def move(time, pose):
    pose.velocity.x = 0
    pose.position.x = 0*time


def watch(world, number):
    return 0


def bed(side=10, layers=8, law=law, **more):
    """A bed of side x side x layers spheres at rest in a box."""
    world = dem.World(gravity=(0, 0, -9.81), dt=2e-5, threads=1, law=law, law_stiffness=1e3 if law else 0, **more)
    glass = world.material(density=2500, young=1e7, poisson=0.25, restitution=0.8)
    floor = world.wall_plane(glass, (0, 0, 0), (0, 0, 1))
    r = 0.002
    for i, (normal, at) in enumerate((((1, 0, 0), 0), ((-1, 0, 0), 2*r*side), ((0, 1, 0), 0), ((0, -1, 0), 2*r*side))):
        world.wall_plane(glass, (at, 0, 0) if i < 2 else (0, at, 0), normal)
    world.spheres(glass, [(r + 2*r*i, r + 2*r*j, r + 1.99*r*k) for i in range(side) for j in range(side) for k in range(layers)],
                  radius=r)
    world.step(100)
    return world, floor


def seconds(function, rounds=5):
    best = 1e300
    for _ in range(rounds):
        began = time.thread_time()
        function()
        best = min(best, time.thread_time() - began)
    return best


def main():
    lines = []

    def put(name, value, unit):
        lines.append("%s = %.3g %s" % (name, value, unit))
        print(lines[-1], flush=True)

    header = os.path.dirname(dem._header())
    dem.load()
    with tempfile.TemporaryDirectory() as work:
        source, path = os.path.join(work, "c.c"), os.path.join(work, "c.so")
        with open(source, "w") as file:
            file.write(C)
        subprocess.run(os.environ.get("CC", "cc").split() + ["-O2", "-shared", "-fPIC", "-I" + header, source, "-o", path, "-lm"],
                       check=True)
        c = ctypes.CDLL(path)
        c.loop.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int]
        steps = 60

        def measure(n, **more):
            world, floor = bed(**more)
            return world, seconds(lambda: world.step(n))/n

        def loops(side, layers, n):
            """Seconds of a step: in a loop in C, in a loop in Python."""
            world, _ = bed(side, layers, law=None)
            step = ctypes.cast(dem._lib.dem_world_step.entry, ctypes.c_void_p)
            in_c = seconds(lambda: c.loop(step, world._at, n))
            world, _ = bed(side, layers, law=None)          # the same states again
            in_python = seconds(lambda: [world.step(1) for _ in range(n)])
            return in_c/n, in_python/n

        for side, layers, n in ((1, 1, 20000), (10, 8, 200)):
            in_c, in_python = loops(side, layers, n)
            put("step.spheres%d.c" % (side*side*layers), 1e6*in_c, "us")
            put("step.spheres%d.python" % (side*side*layers), 1e6*in_python, "us")
        world, _ = bed()
        ball = world.body_id(0)
        n = 10000
        for name, function in (("time", lambda: world.time), ("state", lambda: ball.state), ("positions", lambda: world.bodies.positions),
                               ("memory", lambda: world.bodies_memory.positions),
                               ("run", lambda: world.run(0))):
            put("call.%s" % name, 1e6*seconds(lambda: [function() for _ in range(n)])/n, "us")

        world, plain = measure(steps, law=c.law)
        counters = world.counters
        contacts = counters.contacts + counters.wall_contacts
        other, python = measure(steps, law=law)
        if other.hash != world.hash:
            sys.exit("overhead.py: the law in Python does not compute what the law in C computes")
        put("contacts", contacts, "")
        put("law.c", 1e6*plain/contacts, "us per contact and step, whole step, law by pointer in C")
        put("law.python", 1e6*python/contacts, "us per contact and step, whole step, law in Python")
        put("law.factor", python/plain, "times the step with the law in C")
        _, without = measure(steps, law=None)
        _, in_c = measure(steps, law=None, body_force=c.lift)
        _, in_python = measure(steps, law=None, body_force=lift)
        put("force.c", 1e6*(in_c - without)/800, "us per body and step")
        put("force.python", 1e6*(in_python - without)/800, "us per body and step")

        def each_step(motion=None, function=None):
            world, floor = bed(1, 1, law=None)
            if motion:
                floor.motion_set(kind="user", function=motion)
            if function:
                world.output(function=function, interval=2e-5)
            return seconds(lambda: world.run(0.2))/10000
        empty = each_step()
        put("motion.c", 1e6*(each_step(motion=c.move) - empty), "us per step, two calls")
        put("motion.python", 1e6*(each_step(motion=move) - empty), "us per step, two calls")
        put("output.c", 1e6*(each_step(function=c.watch) - empty), "us per step")
        put("output.python", 1e6*(each_step(function=watch) - empty), "us per step")
    if len(sys.argv) > 1:
        write(sys.argv[1], lines)


def write(page, lines):
    with open(page) as file:
        text = file.read()
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True).stdout.strip() or "unknown"
    processor = platform.processor() or platform.machine()
    try:
        with open("/proc/cpuinfo") as file:
            info = file.read()
        processor = "%s (family %s, model %s)" % tuple(re.search(r"^%s\s*: (.*)" % key, info, re.M).group(1)
                                                      for key in ("model name", "cpu family", "model"))
    except (OSError, AttributeError):
        pass
    value = {line.split(" = ")[0]: line.split(" = ")[1].split()[0] for line in lines}
    rows = [("a step of one sphere, called one by one", "step.spheres1"), ("a step of 800 spheres, called one by one", "step.spheres800"),
            ("a step with a user-defined law, per contact", "law"), ("`body_force`, per body and step", "force"),
            ("`function` of a motion, per step (two calls)", "motion"), ("`function` of an output, per step", "output")]
    table = "| what | in C, us | in Python, us |\n|---|---|---|\n" + "".join(
        "| %s | %s | %s |\n" % (about, value[key + ".c"], value[key + ".python"]) for about, key in rows)
    table += "\n| call from Python | us |\n|---|---|\n" + "".join("| `%s` | %s |\n" % (about, value[key]) for about, key in (
        ("world.time", "call.time"), ("body.state", "call.state"), ("world.bodies.positions", "call.positions"),
        ("world.bodies_memory.positions", "call.memory"), ("world.run(0)", "call.run")))
    block = "<!-- overhead begins: python3 examples/python/overhead.py docs/python.md; %s; Python %s; commit %s -->\n%s<!-- overhead ends -->" % (
        processor, platform.python_version(), commit, table.replace(" us ", " µs "))
    found = re.search(r"<!-- overhead begins.*?<!-- overhead ends -->", text, re.S)
    if not found:
        sys.exit("overhead.py: %s has no place for the figures" % page)
    with open(page, "w") as file:
        file.write(text[:found.start()] + block + text[found.end():])


if __name__ == "__main__":
    main()
