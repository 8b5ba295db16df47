"""python3 tests/python/check.py [WORDS] : tests of examples/python. WORDS: only tests whose names contain the words.

LONG=1 runs whole lessons instead of a part of each. The C lessons that they are compared with have left their output in
build/out/NAME/log (make lessons); those that have not are run. The last line is "N passed, N failed"."""
import concurrent.futures
import contextlib
import copy
import ctypes
import gc
import importlib.util
import inspect
import io
import json
import math
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import traceback
import warnings
import weakref

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
PYTHON = os.path.join(ROOT, "examples", "python")
os.environ.setdefault("DEM_BUILD", os.path.join(ROOT, "build"))
os.environ.setdefault("OMP_WAIT_POLICY", "passive")
sys.path[:0] = [PYTHON, os.path.dirname(os.path.abspath(__file__))]
sys.dont_write_bytecode = True
import dem  # noqa: E402

LONG = bool(os.environ.get("LONG"))
WORK = tempfile.TemporaryDirectory()
TESTS = []


def test(name):
    def add(function):
        TESTS.append((name, function))
        return function
    return add


def same(found, expected, what=""):
    if found != expected:
        raise AssertionError("%s: %r instead of %r" % (what or "value", found, expected))


def near(found, expected, part=1e-12):
    if not abs(found - expected) <= part*abs(expected):
        raise AssertionError("%r instead of %r" % (found, expected))


def raises(kind, function, *words):
    try:
        function()
    except kind as error:
        for word in words:
            if word not in str(error):
                raise AssertionError("the message %r lacks %r" % (str(error), word)) from None
        return error
    raise AssertionError("no %s was raised" % kind.__name__)


def heap(**more):
    """A world with a floor and glass."""
    world = dem.World(gravity=(0, 0, -9.81), **more)
    glass = world.material(density=2500, young=1e7, poisson=0.25, restitution=0.5, friction=0.5)
    world.wall_plane(glass, (0, 0, 0), (0, 0, 1))
    return world, glass


def compiled(name, text, *flags):
    """A program or a library of C text."""
    source, path = os.path.join(WORK.name, name + ".c"), os.path.join(WORK.name, name)
    with open(source, "w") as file:
        file.write(text)
    subprocess.run(os.environ.get("CC", "cc").split() + ["-O1", "-I" + ROOT, source, "-o", path, "-lm"] + list(flags), check=True)
    return path


# ---- the file itself, layouts ----

@test("a number that is none or does not fit is refused by name: fields, arguments, elements, vectors")
def _():
    world, glass = heap()
    text = "7"
    for call, *words in ((lambda: world.material(density=text, young=1e6, restitution=0.5), "World.material: density: "),
                         (lambda: world.material(density=True, young=1e6, restitution=0.5), "World.material: density: ", "True"),
                         (lambda: dem.World(threads=1.5), "World: threads: ", "1.5"),
                         (lambda: dem.World(body_reals=5), "World: body_reals: "),
                         (lambda: world.step(1.5), "World.step: steps: ", "1.5"), (lambda: world.step(text), "World.step: steps: "),
                         (lambda: world.sphere(glass, text, (0, 0, 1)), "World.sphere: radius: "),
                         (lambda: world.sphere(glass, 0.001, (0, 0, text)), "World.sphere: position: ", "Vec3.z"),
                         (lambda: dem.FeedDesc(radius=(0.001, text)), "FeedDesc.radius"),
                         (lambda: setattr(dem.WorldDesc(), "threads", text), "WorldDesc.threads"),
                         (lambda: copy.deepcopy(world), "World", "copied")):
        raises(TypeError, call, *words)
    for wide in (2**32 + 1, -2**32 + 2, 2**31, 2**64):
        raises(OverflowError, lambda: world.step(wide), "World.step", str(wide))
        raises(OverflowError, lambda: dem.World(threads=wide), "World: threads: ", str(wide))
        raises(OverflowError, lambda: setattr(dem.WorldDesc(), "threads", wide), "WorldDesc.threads")
    raises(ValueError, lambda: dem.Selection(bodies=[dem.Body(1, 0)], count=100), "Selection.count", "100")
    same(dem.Region(box=(0, 0, 0, 1, 1, 1), cylinder="z").cylinder, ord("z"))
    world.step(2)


@test("dem.py is what make.py makes of dem.h")
def _():
    made = subprocess.run([sys.executable, os.path.join(PYTHON, "make.py")], capture_output=True, text=True, check=True).stdout
    with open(os.path.join(PYTHON, "dem.py")) as file:
        same(made == file.read(), True, "the file (make python makes it again)")


@test("dem.pyi is what make.py makes, and has every public name, method and argument of dem.py")
def _():
    import ast
    made = subprocess.run([sys.executable, os.path.join(PYTHON, "make.py"), "--stubs"], capture_output=True, text=True, check=True).stdout
    with open(os.path.join(PYTHON, "dem.pyi")) as file:
        same(made == file.read(), True, "the file (make python makes it again)")
    tree, names = ast.parse(made), set()

    def arguments(node):
        return [a.arg for a in node.args.args + node.args.kwonlyargs]
    for node in tree.body:
        if isinstance(node, ast.AnnAssign):
            names.add(node.target.id)
        elif isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            names.add(node.name)
        if isinstance(node, ast.FunctionDef):
            same(arguments(node), list(inspect.signature(getattr(dem, node.name)).parameters), node.name)
        elif isinstance(node, ast.ClassDef):
            kind = getattr(dem, node.name)
            members = {part.name: part for part in node.body if isinstance(part, ast.FunctionDef)}
            for name, part in members.items():
                static = inspect.getattr_static(kind, name)
                same(any(isinstance(d, ast.Name) and d.id == "property" for d in part.decorator_list), isinstance(static, property), name)
                if not isinstance(static, (property, classmethod)) and name[0] != "_":
                    same(arguments(part), list(inspect.signature(static).parameters), "%s.%s" % (node.name, name))
            if issubclass(kind, (dem.Handle, dem.Id)) and kind.__name__ not in ("Handle", "Id"):
                fields = {part.target.id for part in node.body if isinstance(part, ast.AnnAssign)}
                same(sorted(name for name in vars(kind) if name[0] != "_" and name not in members and name not in fields
                            and name not in ("rows", "c_name", "counts", "kinds", "counted", "lengths", "numbers", "whole")), [], kind.__name__)
    public = {name for name, value in vars(dem).items() if name[0] != "_" and getattr(value, "__module__", "") == "dem"
              and not isinstance(value, dem.Function) and not isinstance(value, (dem.View, dem._Library))}
    same(sorted(public - names - {"View", "Text", "Choices", "Function", "Handle"}), [], "names without types")
    same(dem.__version__, "%d.%d.%d" % (dem.VERSION_MAJOR, dem.VERSION_MINOR, dem.VERSION_PATCH))
    same('one of "hertz"' in dem.World.__init__.__doc__ and '"rotating"' in dem.Wall.motion_set.__doc__, True, "words of enums in docstrings")


@test("every public struct has the size and the offsets of C, in double and in single precision")
def _():
    with open(os.path.join(ROOT, "dem.h")) as file:
        text = file.read()
    public = text[text.index("\n#ifndef DEM_H\n"):text.index("#endif /* DEM_H */")]
    names = set(re.findall(r"^(?:typedef )?struct (dem_\w+) \{", public, re.M))
    same({kind.c_name for kind in dem.structs}, names, "structs")
    lines = []
    for kind in dem.structs:
        lines.append('printf("%s %%d\\n", (int)sizeof(%s));' % (kind.c_name, kind.c_name))
        for name in kind.kinds:
            lines.append('printf("%s.%s %%d %%d\\n", (int)offsetof(%s, %s), (int)sizeof(((%s *)0)->%s));' % (
                kind.c_name, name.rstrip("_"), kind.c_name, name.rstrip("_"), kind.c_name, name.rstrip("_")))
    program = '#include "dem.h"\nint main(void) { %s return 0; }\n' % "\n".join(lines)
    here = ("import os, sys, ctypes; sys.path.insert(0, %r); import dem\nfor kind in dem.structs:\n"
            "    print(kind.c_name, ctypes.sizeof(kind))\n    for (raw, _), name in zip(kind._fields_, kind.kinds):\n"
            "        field = getattr(kind, raw)\n"
            "        print('%%s.%%s' %% (kind.c_name, name.rstrip('_')), field.offset, field.size)\n" % PYTHON)
    for real in ("double", "float"):
        path = compiled("layout_" + real, program, "-DDEM_REAL=" + real)
        c = subprocess.run([path], capture_output=True, text=True, check=True).stdout.split("\n")
        python = subprocess.run([sys.executable, "-B", "-c", here], capture_output=True, text=True, check=True,
                                env=dict(os.environ, DEM_REAL=real)).stdout.split("\n")
        for one, other in zip(c, python):
            same(other, one, real)
        same(len(python), len(c), "fields")


@test("every public function and constant of dem.h is there, under a name and with a docstring")
def _():
    with open(os.path.join(ROOT, "dem.h")) as file:
        text = file.read()
    public = text[text.index("\n#ifndef DEM_H\n"):text.index("#endif /* DEM_H */")]
    with open(os.path.join(PYTHON, "dem.py")) as file:
        code = file.read()
    for name in re.findall(r"^DEM_API [\w ]+[ *](dem_\w+)\(", public, re.M):
        same(bool(re.search(r"_lib\.%s\b" % name, code[:code.index("_FUNCTIONS = [")] + code[code.index("_FUNCTIONS = ["):].split("]\n")[-1])
                  or name in code.split("class _Memory")[0]), True, name)
    for name in re.findall(r"^ *(DEM_[A-Z_0-9]+)(?: = \d+)?,? *(?:/\*.*)?$|enum \{ (DEM_\w+) =", public, re.M):
        name = name[0] or name[1]
        found = hasattr(dem, name[4:]) or any(name.endswith("_" + member) or name[4:] == member for kind in vars(dem).values()
                                              if isinstance(kind, type) and issubclass(kind, dem.enum.IntEnum) for member in kind.__members__)
        same(found, True, name)
    for kind in (dem.World, dem.Body, dem.Wall, dem.Replay, dem.Slabs):
        for name, member in vars(kind).items():
            if not name.startswith("_"):
                same(bool(inspect.getdoc(member)), True, "docstring of %s.%s" % (kind.__name__, name))
    same("kg/m3, required, > 0" in dem.World.material.__doc__, True, "fields in the docstring")


# ---- errors ----

@test("a result other than DEM_OK raises the exception of its name with the error message of the library")
def _():
    world, glass = heap()
    error = raises(dem.ArgumentError, lambda: world.run(-1), "dem_world_run", "-1")
    same(error.result, dem.Result.ERROR_ARGUMENT)
    same(isinstance(error, ValueError), True, "ArgumentError is a ValueError")
    raises(dem.FileError, lambda: world.mesh_read("/nowhere/mesh.stl"), "/nowhere/mesh.stl")
    raises(dem.FormatError, lambda: world.mesh_parse("text", "solid x\nfacet normal 0 0 1\n"), "text")
    world.sphere(glass, 0.01, (0, 0, 0.0099))
    world.dt_set(0.1)
    raises(dem.TimeStepError, lambda: world.step(1), "dem_world_step")


@test("a null id raises the error message, and a scene goes on after the exception was caught")
def _():
    world, glass = heap()
    raises(dem.Error, lambda: world.sphere(glass, -1, (0, 0, 1)), "radius", "-1")
    raises(dem.Error, lambda: world.material(density=-1), "density")
    raises(dem.ArgumentError, lambda: dem.World(dt=-1), "dem_world_create: dt")
    world.sphere(glass, 0.01, (0, 0, 1))
    world.run(0.01)
    same(world.bodies.count, 1)


@test("a wrong field, a wrong word and a wrong number of coordinates are refused before C sees them")
def _():
    world, glass = heap()
    raises(TypeError, lambda: world.material(densty=1), "densty")
    raises(TypeError, lambda: dem.MaterialDesc(densty=1), "densty", "density")
    raises(ValueError, lambda: dem.World(normal_law="cubic"), "cubic", "hertz")
    raises(ValueError, lambda: world.spheres(glass, [(0, 0, 1), (0, 0)], radius=0.01), "positions")
    raises(ValueError, lambda: world.spheres(glass, [(0, 0, 1)], velocities=[1, 2], radius=0.01), "velocities")
    raises(AttributeError, lambda: setattr(dem.Motion(), "sped", 1), "sped")
    raises(Exception, lambda: world.sphere(None, 0.01, (0, 0, 1)), "material")


@test("a fill that finds less room than it needs warns, and one that finds none raises")
def _():
    world, glass = heap()
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        added = world.spheres_fill(glass, 0.01, (0, 0, 0, 0.05, 0.05, 0.05), 500, 1)
    same(0 < added < 500 and len(seen) == 1 and "dem_spheres_fill" in str(seen[0].message), True, "warning")
    raises(dem.Error, lambda: world.spheres_fill(glass, 0.01, (0, 0, 0, 0.001, 0.05, 0.05), 5, 1), "dem_spheres_fill")


@test("calls on a world that is closed raise an error")
def _():
    with heap()[0] as world:
        pass
    raises(dem.Error, lambda: world.run(1), "World.run: this world is closed")
    world.close()


# ---- lifetimes ----

@test("a world that nothing refers to is freed, with its replay and its functions")
def _():
    path = os.path.join(WORK.name, "freed.html")
    freed = []

    def scene():
        def law(c, memory, force):
            force.normal = 1e4*c.overlap + world.time*0
        world = dem.World(law=law, law_memory=1, law_stiffness=1e4, gravity=(0, 0, -9.81))
        glass = world.material(density=2500, young=1e7, restitution=1)
        world.sphere(glass, 0.01, (0, 0, 1))
        world.replay(path, interval=0.001)
        world.run(0.01)
        weakref.finalize(law, freed.append, "law")
        return weakref.ref(world)

    world = scene()
    gc.collect()
    same(world(), None, "world")
    same(freed, ["law"], "law")
    same(os.path.getsize(path) > 1000, True, "the replay is complete")


@test("a world, its replay, its slabs and its memory may be ended in any order, as the garbage collector does")
def _():
    path = os.path.join(WORK.name, "order.html")
    code = ("import itertools, os, sys; sys.path.insert(0, %r); import dem\n"
            "for order in itertools.permutations(range(4)):\n"
            "    world = dem.World(gravity=(0, 0, -9.81))\n"
            "    world.sphere(world.material(density=2500, young=1e7, restitution=0.5), 0.01, (0, 0, 1))\n"
            "    replay = world.replay(%r, interval=0.001)\n"
            "    world.run(0.01)\n"
            "    parts = world, replay, world.slabs(axis=0, count=2), world._memory\n"
            "    for part in order:\n"
            "        parts[part].__del__()\n"
            "    for call in (lambda: world.step(1), replay.frame_write):\n"
            "        try:\n"
            "            call()\n"
            "            print('no error after', order)\n"
            "        except dem.Error:\n"
            "            pass\n"
            "    with open(%r) as file:\n"
            "        print(file.read().rstrip()[-9:])\n" % (PYTHON, path, path))
    done = subprocess.run([sys.executable, "-B", "-c", code], capture_output=True, text=True,
                          env=dict(os.environ, MALLOC_PERTURB_="165"))   # memory that is freed is overwritten
    same((done.returncode, done.stderr, set(done.stdout.split())), (0, "", {"</script>"}))


@test("a world that is closed completes all its replays, also when one of them cannot be written")
def _():
    folder = os.path.join(WORK.name, "gone")
    os.mkdir(folder)
    paths = [os.path.join(WORK.name, "complete%d.html" % i) for i in range(6)]
    world = heap()[0]
    positions = world.bodies.positions                      # holds the memory of the world
    replays = [world.replay(path, interval=0.001) for path in paths[:3] + [os.path.join(folder, "x.html")] + paths[3:]]
    world.run(0.01)
    for name in os.listdir(folder):
        os.remove(os.path.join(folder, name))
    os.rmdir(folder)
    raises(dem.FileError, world.close, "x.html")
    for replay in replays:
        raises(dem.Error, replay.frame_write, "this replay is closed")
    same([os.path.getsize(path) > 1000 for path in paths], [True]*6, "files")
    del positions


@test("a replay that nothing refers to records the run until its world is closed")
def _():
    sizes = []
    for seconds in (0, 0.1):
        path = os.path.join(WORK.name, "closed.html")
        with heap()[0] as world:
            world.sphere(dem.Material(1), 0.01, (0, 0, 1))
            world.replay(path, interval=0.001)
            gc.collect()
            world.run(seconds)
        world.close()
        sizes.append(os.path.getsize(path))
    same(sizes[1] > sizes[0] + 500, True, "a hundred frames in %d and %d bytes" % tuple(sizes))


@test("a view of an array keeps the memory of its world, also after close")
def _():
    world, glass = heap()
    world.sphere(glass, 0.01, (1, 2, 3))
    positions = world.bodies.positions
    world.close()
    del world
    gc.collect()
    same(positions.tolist(), [[1, 2, 3, 0.01]])


@test("many worlds in a row need the memory of one")
def _():
    def resident():
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1])
    if not os.path.exists("/proc/self/statm"):
        return
    for i in range(200):
        world, glass = heap(body_force=lambda body, id, time, force, torque: None)
        world.spheres_fill(glass, 0.01, dem.Region(box=(0, 0, 0, 1, 1, 1), inside=lambda centre, radius: 1), 20, 1)
        world.step(2)
        if i == 50:
            gc.collect()
            begun = resident()
    gc.collect()
    if resident() > begun + 1000:                           # pages of 4 kB; a world has 200 of them
        raise AssertionError("%d pages more after 150 worlds" % (resident() - begun))


# ---- buffers ----

@test("rows of world.bodies are in the order of adding, also after the neighbour list was rebuilt, and numpy takes them")
def _():
    world, glass = heap()
    grid = [(0.004*i, 0.004*j, 0.01 + 0.004*k) for k in reversed(range(6)) for j in range(6) for i in reversed(range(6))]
    world.spheres(glass, grid, radius=0.001)
    same([row[:3] for row in world.bodies.positions.tolist()], [list(point) for point in grid])
    world.step(1)
    same(world.bodies_memory.slots.tolist() != sorted(world.bodies_memory.slots.tolist()), True, "dem.h has sorted its rows")
    moved = max(abs(a - b) for row, point in zip(world.bodies.positions.tolist(), grid) for a, b in zip(row, point))
    same(moved < 1e-6, True, "m moved in a step: %g" % moved)
    bodies = world.bodies
    same(bodies.slots.tolist(), list(range(216)))
    same((len(bodies), len(world), len(list(bodies)), bodies[7].slot, bodies[-1].slot, world.body_id(3)), (216, 216, 216, 8, 216, bodies[3]))
    same([body.state.position.x for body in bodies[:3]], [row[0] for row in bodies.positions.tolist()[:3]])
    raises(IndexError, lambda: bodies[216], "216")
    raises(dem.Error, lambda: world.body_id("a"), "'a'")
    raises(TypeError, lambda: bodies.positions.__setitem__((0, 0), 1.0))
    bodies[0].remove()
    same((len(bodies), bodies[0].slot, bodies.positions.tolist()[0][:2]), (215, 2, bodies[0].state.position[:2] and list(bodies[0].state.position[:2])))
    world.step(1)
    late = world.sphere(glass, 0.001, (0, 0, 0.5))
    same((late.slot, bodies[0]), (1, late), "a body that is added after another was removed takes its place")
    same(dem.World().bodies.count, 0)
    same(dem.World().bodies.positions, None)


@test("world.bodies_memory has the arrays of the library without a copy, and read only")
def _():
    world, glass = heap()
    world.spheres(glass, [(0, 0, 1), (1, 0, 1)], velocities=[(1, 2, 3), (4, 5, 6)], radii=[0.01, 0.02])
    bodies = world.bodies_memory
    same(bodies.positions.shape, (2, 4))
    same(bodies.velocities.tolist(), [[1, 2, 3, 0], [4, 5, 6, 0]])
    before = bodies.positions
    world.body_id(0).set(position=(7, 0, 1))
    same(world.bodies.positions[0, 0], 7.0)
    same(before[0, 0], 7.0, "the view sees the change: no copy")
    raises(TypeError, lambda: bodies.positions.__setitem__((0, 0), 1.0))
    same(bodies.slots.tolist(), [0, 1])


@test("all positions, velocities and spins are set by one assignment")
def _():
    world, glass = heap()
    world.spheres(glass, [(0.1*i, 0, 1) for i in range(5)], radius=0.01)
    world.bodies.velocities = [(i, 0, 1) for i in range(5)]
    world.bodies.spins = [(0, i, 0) for i in range(5)]
    same([body.state.velocity.x for body in world.bodies], [0, 1, 2, 3, 4])
    same([row[1] for row in world.bodies.spins.tolist()], [0, 1, 2, 3, 4])
    raises(ValueError, lambda: setattr(world.bodies, "velocities", [(1, 2, 3)]), "World.bodies.velocities", "(1, 3)", "(5, 3)")
    raises(AttributeError, lambda: setattr(world.bodies, "masses", [1]*5), "World.bodies.masses")
    columns = world.bodies.to_dict()
    same((columns["vx"], len(columns["mass"])), ([0, 1, 2, 3, 4], 5))


@test("numpy views rows without a copy, and arrays of numpy are accepted")
def _():
    try:
        import numpy
    except ImportError:
        print("SKIP: numpy not found (Debian package python3-numpy): its views are not tested")
        return
    world, glass = heap()
    world.spheres(glass, numpy.arange(30.0).reshape(10, 3) + [0, 0, -1.901], radii=numpy.full(10, 0.1))
    view = numpy.asarray(world.bodies_memory.positions)
    same((view.shape, numpy.asarray(world.bodies.positions).shape), ((10, 4), (10, 4)))
    world.body_id(3).set(position=(-5, 0, 50))
    same(view[3, 0], -5.0)
    world.step(1)
    same(len(world.contacts), 1)
    kind = numpy.dtype(dem.ContactInfo)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        contacts = numpy.asarray(world.contacts)
    same((contacts.dtype, contacts.shape), (kind, (1,)))
    same((kind.names[:2], kind.itemsize, contacts["point"]["z"].dtype), (("a", "b"), ctypes.sizeof(dem.ContactInfo), numpy.dtype("f8")))
    for array in (numpy.eye(3, dtype=">f8"), numpy.eye(3, dtype="f2"), numpy.eye(3, dtype="i8"), numpy.asfortranarray(numpy.eye(3)),
                  numpy.arange(18.0).reshape(3, 6)[:, ::2]):
        other, glass = heap()
        other.spheres(glass, array, radius=0.01)
        same([row[:3] for row in other.bodies.positions.tolist()], array.tolist())
    for array in (numpy.zeros((2, 4)), numpy.zeros((3, 4)), numpy.zeros((2, 2, 2)), numpy.array([[1j, 0, 0]]), numpy.array([[True]*3]),
                  numpy.array([["a", "b", "c"]]), numpy.array([[1, 2, None]], dtype=object)):
        raises(dem.Error, lambda: other.spheres(glass, array, radius=0.01), "World.spheres: positions: ")
    raises(dem.Error, lambda: other.spheres(glass, numpy.array(1.0), radius=0.01), "World.spheres: positions: ")
    v = dem.Vec3(3, 4, 0)
    same((numpy.linalg.norm(v), (numpy.ones(3) + v).tolist(), (v*numpy.ones(3)).tolist(), numpy.array(tuple(v)).tolist()),
         (5.0, [4, 5, 1], [3, 4, 0], [3, 4, 0]))
    same((numpy.dot(v, (1, 2, 3)), numpy.cross(v, v).tolist(), numpy.sqrt(dem.Vec3(4, 9, 16)).tolist()), (11.0, [0, 0, 0], [2, 3, 4]))


@test("arrays are taken from lists, tuples, buffers and arrays of ctypes")
def _():
    import array
    flat = [0, 0, 1, 1, 0, 1]
    hashes = set()
    for positions in (flat, [(0, 0, 1), (1, 0, 1)], array.array("d", flat), (ctypes.c_double*6)(*flat), [dem.Vec3(0, 0, 1), dem.Vec3(1, 0, 1)]):
        world, glass = heap()
        world.spheres(glass, positions, radius=0.01)
        world.step(10)
        hashes.add(world.hash)
    same(len(hashes), 1, "digests")


@test("an array whose last axis does not fit raises ValueError with both shapes")
def _():
    world, glass = heap()
    for positions, *words in (([(0, 0, 0, 1)], "(4,)", "(N, 3)"), ([(0, 0, 1), (0, 0)], "(2,)", "(N, 3)"), ([(0, 0)]*3, "(2,)", "(N, 3)"),
                              ([1, 2, 3, 4], "4 numbers", "(N, 3)"), ([1, (1, 2, 3)], "mixed"), ([], "World.spheres")):
        if positions:
            raises(ValueError, lambda: world.spheres(glass, positions, radius=0.01), "World.spheres: positions: ", *words)
    for positions in ("abc", b"abc", {"x": 1}, {1, 2, 3}, 5, None, dem, [["a", "b", "c"]], [{"x": 1}]*3, object()):
        raises(TypeError, lambda: world.spheres(glass, positions, radius=0.01), "World.spheres: positions: ")
    view = memoryview((ctypes.c_double*18)()).cast("B").cast("d", [3, 6])
    error = raises(ValueError, lambda: world.spheres(glass, view, radius=0.01), "(3, 6)", "(N, 3)", "transpose")
    same(isinstance(error, dem.Error), True)
    raises(ValueError, lambda: world.spheres(glass, [(0, 0, 1), (1, 0, 1)], [(0, 0, 1)], radius=0.01), "velocities", "(1, 3)", "(2, 3)")
    raises(ValueError, lambda: world.spheres(glass, [(0, 0, 1), (1, 0, 1)], radii=[1, 2, 3]), "radii", "(3,)", "(2,)")
    shape = world.shape_ellipsoid((3e-3, 2e-3, 2e-3))
    raises(ValueError, lambda: world.bodies_add(glass, shape, [(0, 0, 1)], orientations=[(1, 0, 0)]), "orientations", "(3,)", "(1, 4)")
    raises(ValueError, lambda: dem.Mesh(vertices=[(0, 0), (1, 0), (0, 1)]), "Mesh.vertices", "(2,)", "(N, 3)")
    loop = []
    loop.append(loop)
    raises(dem.Error, lambda: world.spheres(glass, loop, radius=0.01), "positions")

    class Table:
        """What a table of pandas has."""
        shape = (2, 3)

        def __init__(self, rows):
            self.rows = rows

        def __array__(self, dtype=None, copy=None):
            import numpy
            return numpy.array(self.rows)

        def __len__(self):
            return 3

        def __iter__(self):
            return iter("xyz")
    try:
        import numpy  # noqa: F401
    except ImportError:
        return
    world.spheres(glass, Table([[1, 2, 3.5], [4, 5, 6.5]]), radius=0.01)
    same([row[:3] for row in world.bodies.positions.tolist()], [[1, 2, 3.5], [4, 5, 6.5]])


@test("a count that is not that of its array raises ValueError")
def _():
    two = [(0, 0, 0), (1e-3, 0, 0)]
    for call, *words in ((lambda: dem.ClusterDesc(count=50, positions=two, radius=1e-3), "ClusterDesc.count is 50", "2 elements"),
                         (lambda: dem.ClusterDesc(count=1, positions=two, radius=1e-3), "ClusterDesc.count is 1"),
                         (lambda: dem.ClusterDesc(positions=two, radii=[1e-3]), "ClusterDesc.radii has 1 element", "positions has 2"),
                         (lambda: dem.ClusterDesc(count=2), "ClusterDesc.count is 2", "no elements"),
                         (lambda: dem.Mesh(vertex_count=300, vertices=[(0, 0, 0)]), "Mesh.vertex_count is 300"),
                         (lambda: dem.Mesh(vertex_count=3, triangle_count=1), "Mesh.vertex_count is 3"),
                         (lambda: setattr(dem.Mesh(vertices=[(0, 0, 0)]), "vertex_count", 7), "Mesh.vertex_count is 7"),
                         (lambda: dem.Grains(count=9, positions=two, radii=[1, 1]), "Grains.count is 9"),
                         (lambda: dem.Grains(positions=two, radii=[1]), "Grains.radii has 1"),
                         (lambda: dem.FeedDesc(radius=[1e-3, 2e-3], amount=[1]), "FeedDesc.amount has 1"),
                         (lambda: dem.FeedDesc(radius=[1e-3], amount=[1, 2]), "FeedDesc.amount has 2"),
                         (lambda: dem.FeedDesc(radius=[1e-3]*17), "FeedDesc.radius", "at most 16"),
                         (lambda: dem.Sizes(radius=[1, 2, 3], passing=[0, 1]), "Sizes.passing has 2"),
                         (lambda: dem.CellDesc(rate=(1, 2)), "CellDesc.rate")):
        raises(ValueError, call, *words)
    mesh = dem.Mesh(vertices=[(0, 0, 0), (1, 0, 0)])
    mesh.vertices = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
    same((mesh.vertex_count, dem.Mesh(vertex_count=1, vertices=[(0, 0, 0)]).vertex_count), (3, 1))


@test("an assignment to a world, an id or a copy of a state sets it or raises AttributeError that names the call")
def _():
    world, glass = heap()
    wall = world.wall_plane(glass, (0, 0, 5), (0, 0, -1))
    ball = world.sphere(glass, 0.01, (0, 0, 1))
    world.gravity, world.dt = (0, 0, -1), 1e-5
    same((world.gravity, world.dt, world.desc.gravity.z), ((0, 0, -1), 1e-5, -1.0))
    state = ball.state
    for target, name, *words in ((world, "threads", "World(threads=...)"), (world, "friction", "friction"), (world, "time", "World.time"),
                                 (world, "run", "World.run"), (ball, "velocity", "Body.velocity", "set"), (state, "velocity", "Body.set"),
                                 (state.velocity, "x", "Body.set"), (glass.desc, "friction", "Material.set"), (wall, "id", "Wall"),
                                 (world.totals, "mass", "Totals.mass"), (world.desc, "dt", "WorldDesc.dt"),
                                 (dem.Motion(), "sped", "sped", "speed")):
        error = raises(AttributeError, lambda: setattr(target, name, 1), *words)
        same(isinstance(error, dem.Error), True, name)
    copied = copy.copy(state)
    copied.velocity = (1, 2, 3)
    copied.velocity.x = 7
    same((copied.velocity, state.velocity, ball.state.velocity), ((7, 2, 3), (0, 0, 0), (0, 0, 0)))


@test("an unknown group raises with the names that there are, and removes nothing")
def _():
    world = dem.World(groups=["top", "low"])
    glass = world.material(density=2500, young=1e7, poisson=0.25, restitution=0.5)
    world.sphere(glass, 0.01, (0, 0, 1))
    raises(ValueError, lambda: world.bodies_remove(group=world.group("tpo")), "tpo", "top low")
    raises(ValueError, lambda: heap()[0].group("top"), "top")
    same((world.bodies.count, world.bodies_remove(group=world.group("low")), world.bodies_remove()), (1, 0, 1))


@test("calls that mean nothing are refused: None for a vector, two of three numbers, one word of three, ids of other worlds")
def _():
    world, glass = heap()
    other, steel = heap()
    body = other.sphere(steel, 0.01, (0, 0, 1))
    for kind, call, *words in (
            (TypeError, lambda: world.sphere(glass, 0.01, None), "World.sphere: position: None"),
            (TypeError, lambda: world.sphere(None, 0.01, (0, 0, 1)), "World.sphere: material: None", "Material"),
            (TypeError, lambda: world.sphere(1, 0.01, (0, 0, 1)), "World.sphere: material: 1 (int)"),
            (TypeError, lambda: world.sphere(body, 0.01, (0, 0, 1)), "World.sphere: material: Body"),
            (ValueError, lambda: dem.World(gravity=(0, -9.81)), "World: gravity: 2 numbers", "3"),
            (ValueError, lambda: dem.World(domain=(1, 1, 1)), "World: domain: ", "3"),
            (TypeError, lambda: dem.World(gravity="down"), "World: gravity: ", "down"),
            (TypeError, lambda: dem.World(gravity=-9.81), "World: gravity: ", "-9.81"),
            (ValueError, lambda: dem.World(boundary=["periodic"], domain=(0, 0, 0, 1, 1, 1)), "World: boundary: ", "1", "3"),
            (TypeError, lambda: dem.World(boundary="periodic"), "World: boundary: ", "3 words"),
            (ValueError, lambda: dem.World(normal_law=77), "World: normal_law: ", "77", "hertz"),
            (TypeError, lambda: dem.Vec3(1, 2), "Vec3", "2 values"),
            (ValueError, lambda: world.sphere(steel, 0.01, (0, 0, 1)), "World.sphere: material", "another world"),
            (ValueError, lambda: world.joint(kind="revolute", a=body), "World.joint: a: ", "another world"),
            (ValueError, lambda: world.bodies_remove(material=steel), "World.bodies_remove: material: ", "another world"),
            (ValueError, lambda: world.bodies_select(dem.Selection(bodies=[body])), "bodies[0]", "another world"),
            (ValueError, lambda: world.sphere(glass, -1, (0, 0, 1)), "radius"),
            (ValueError, lambda: world.spheres(glass, [(0, 0, 1)], radii=[-1]), "radi")):
        same(isinstance(raises(kind, call, *words), dem.Error), True)
    other.close()
    raises(ValueError, lambda: world.sphere(steel, 0.01, (0, 0, 1)), "closed")
    raises(ValueError, lambda: body.state, "closed")
    same(world.bodies.count, 0)


# ---- functions ----

@test("a law, a force or a motion that returns a number, and an observer that returns none, are refused by name")
def _():
    for more, name in (({"law": lambda c, memory, force: 1.5, "law_stiffness": 1e4}, "law"), ({"force": lambda *_: None}, "force"),
                       ({"force": lambda *_: (1, 2)}, "force"), ({"body_force": lambda *_: (0, 0, 1)}, "body_force")):
        world, glass = heap(**more)
        world.sphere(glass, 0.01, (0, 0, 0.0099))
        same(isinstance(raises(TypeError, lambda: world.run(0.1), name, "returned" if name != "force" else "return"), dem.Error), True)
    world, glass = heap()
    wall = world.wall_plane(glass, (0, 0, 5), (0, 0, -1))
    world.sphere(glass, 0.01, (0, 0, 1))
    raises(TypeError, lambda: (wall.motion_set(kind="user", function=lambda time, pose: 0), world.run(0.1)), "motion", "returned 0")
    world, glass = heap()
    world.spheres(glass, [(0, 0, 0.1), (1, 0, 0.1)], radius=0.01)
    raises(TypeError, lambda: world.trials_run(duration=.01, budget=.1, observables=[dem.Observable(name="a", function=lambda w: None)]),
           "observer", "None was returned", "number")


@test("a struct that a function keeps raises instead of showing what dem.h writes there later")
def _():
    for name in ("law", "body_force", "motion"):
        kept = []

        def law(contact, memory, force):
            kept.append(contact if len(kept) % 2 else contact.normal)

        def lift(body, id, time, force, torque):
            kept.append(body)

        def move(time, pose):
            kept.append(pose)
        world, glass = heap(**{"law": {"law": law, "law_stiffness": 1e4}, "body_force": {"body_force": lift}}.get(name, {}))
        wall = world.wall_plane(glass, (0, 0, 5), (0, 0, -1))
        world.sphere(glass, 0.01, (0, 0, 0.0099))
        raises(ValueError, lambda: (wall.motion_set(kind="user", function=move) if name == "motion" else None, world.run(0.1)),
               "keeps its argument", "copy.copy")
        same(len(kept), 1, name)
    kept = []
    world, glass = heap(body_force=lambda body, id, time, force, torque: kept.append(copy.copy(body)))
    world.sphere(glass, 0.01, (0, 0, 0.5))
    world.run(0.01)
    same(len({body.position.z for body in kept}) > 3, True, "copies differ")


@test("a built-in law without its contact history is refused by name")
def _():
    def run(function, **more):
        world, glass = heap(law=function, law_stiffness=1e4, **more)
        world.sphere(glass, 0.01, (0, 0, 0.0099))
        world.run(0.001)
    for law, needs in dem._LAW_NEEDS.items():
        def call(c, memory, force):
            getattr(dem, "law_" + law[4:])(c, memory, force)
        if needs[0]:
            raises(ValueError, lambda: run(call), "dem." + law, "law_memory=%d" % needs[0])
        if needs[1]:
            raises(ValueError, lambda: run(call, law_memory=needs[0]), "dem." + law, "law_vectors=1")
        run(call, law_memory=needs[0], law_vectors=needs[1])
    raises(ValueError, lambda: run(lambda c, m, f: dem.law_spring(c, dem.tail(m, 3), f), law_memory=5, law_vectors=1), "2 are here")
    raises(ValueError, lambda: run(lambda c, m, f: dem.law_spring(c, dem.tail(m, 1), f), law_memory=5, law_vectors=1), "vector")
    for memory in (None, [0, 0, 0], 5, "abc", (ctypes.c_float*3)()):
        raises(TypeError, lambda: dem.law_spring(dem.Contact(), memory, dem.ContactForce()), "dem.law_spring: memory: ")
    raises(TypeError, lambda: dem.law_spring(None, (dem.Real*3)(), dem.ContactForce()), "dem.law_spring: c: None")
    raises(TypeError, lambda: dem.law_spring(dem.Contact(), (dem.Real*3)(), dem.Contact()), "dem.law_spring: f: ")


@test("a misspelled attribute of a world, of its bodies or of a struct is a dem.Error that names the right one")
def _():
    world, glass = heap()
    raises(dem.NoFieldError, lambda: world.totals.kinetc, "totals.kinetic")
    raises(dem.NoFieldError, lambda: world.sphere_add, "world.sphere")
    raises(dem.NoFieldError, lambda: world.bodies.position, "positions")
    raises(dem.NoFieldError, lambda: world.bodies.radii, "column 3")
    raises(dem.NoFieldError, lambda: dem.Contact().overlp, "contact.overlap")
    same([hasattr(thing, "shape") for thing in (world, world.bodies, dem.Vec3(1, 2, 3))], [False, False, False])
    same(copy.deepcopy(world.totals), world.totals)


@test("dem.compile makes a law of a text in C; another text, another precision and a wrong text are told apart")
def _():
    text = "#include \"dem.h\"\nvoid law(const dem_contact *c, dem_real *m, dem_contact_force *f) { (void)m; f->normal = %g*c->overlap; }\n"

    def depth(stiffness):
        world, glass = heap(law=dem.compile(text % stiffness).law, law_stiffness=1e5)
        world.sphere(glass, 0.01, (0, 0, 0.01))
        world.step(400)
        return world.counters.overlap_max
    same(depth(1e4) > 2*depth(1e5), True, "a softer law is indented deeper")
    same(depth(1e4), depth(1e4))
    path = os.path.join(WORK.name, "law.c")
    with open(path, "w") as file:
        file.write(text % 1e4)
    same(dem.compile(path)._name, dem.compile(text % 1e4)._name)
    raises(ValueError, lambda: dem.compile("#define DEM_REAL float\n" + text % 1), "4 bytes", "8") if dem.Real is ctypes.c_double else None
    raises(ValueError, lambda: dem.compile("\nint law(void) { return wrong; }\n"), "does not compile", "source:2")
    raises(ValueError, lambda: dem.compile("int f("), "does not compile", "source:1", "end of input")
    raises(ValueError, lambda: dem.compile("\nint f(void) { return other(); }\n"), "does not compile", "other")
    library = dem.compile("static int law(void) { return 3; }\nint other(void) { return law(); }\n")
    same(library.other(), 3)
    raises(dem.NoFieldError, lambda: library.law, "'law'", "static")
    raises(TypeError, lambda: dem.compile(5), "dem.compile: source: 5")
    raises(OSError, lambda: dem.compile("/nowhere/law.c"), "/nowhere/law.c")
    other = ctypes.CDLL(compiled("float.so", "const int dempy_real_size = %d;\nvoid law(void) { }\n" % (12 - ctypes.sizeof(dem.Real)),
                                 "-shared", "-fPIC"))
    raises(ValueError, lambda: dem.World(law=other.law), "World: law: ", "compiled for reals of")


@test("a world is not closed by a function that it calls")
def _():
    for more in ({"law": lambda *_: world.close(), "law_stiffness": 1e4}, {"body_force": lambda *_: world.close()}, {}):
        world, glass = heap(**more)
        world.sphere(glass, 0.01, (0, 0, 0.0099))
        if not more:
            world.output(function=lambda copied, number: world.close(), interval=0.001)
        raises(dem.Error, lambda: world.run(0.1), "World.close")
        raises(dem.Error, lambda: world.spheres_fill(glass, 0.001, dem.Region(box=(0, 0, 1, 1, 1, 2), inside=lambda *_: world.close()), 1, 1),
               "World.close")
        world.close()


LAWS = """
#include "dem.h"
void law(const dem_contact *c, dem_real *memory, dem_contact_force *force) {
    const dem_real most = memory[0] > c->overlap ? memory[0] : c->overlap;
    force->normal = 1e4*c->overlap + 3*c->closing_speed;
    force->tangent.x = -2*c->slip.x; force->tangent.y = -2*c->slip.y; force->tangent.z = -2*c->slip.z;
    if (c->dt > 0) memory[0] = most;
}
dem_vec3 wind(dem_vec3 position, dem_vec3 velocity, dem_real radius, dem_real mass, double time, void *user) {
    (void)user; (void)mass;
    return dem_vec3_make(0.01*radius*(1 - velocity.x), 1e-4*time, 1e-5*position.z);
}
void shake(double time, dem_pose *pose, void *user) {
    (void)user;
    pose->position.z = 1e-3*time*time; pose->velocity.z = 2e-3*time;
}
"""


def python_law(c, memory, force):
    most = max(memory[0], c.overlap)
    force.normal = 1e4*c.overlap + 3*c.closing_speed
    slip = c.slip
    force.tangent = (-2*slip.x, -2*slip.y, -2*slip.z)
    if c.dt > 0:
        memory[0] = most


def wind(position, velocity, radius, mass, time):
    return 0.01*radius*(1 - velocity.x), 1e-4*time, 1e-5*position.z


def shake(time, pose):
    pose.position.z = 1e-3*time*time
    pose.velocity.z = 2e-3*time


def box_of(law, force, motion):
    world = dem.World(gravity=(0, 0, -9.81), law=law, law_memory=1, law_stiffness=1e4, force=force, threads=1)
    glass = world.material(density=2500, young=1e7, restitution=1)
    floor = world.wall_plane(glass, (0, 0, 0), (0, 0, 1))
    world.wall_cylinder(glass, (0, 0, 0), (0, 0, 1), 0.03, 1)
    floor.motion_set(kind="user", function=motion)
    world.spheres_fill(glass, 0.005, dem.Region(box=(-0.03, -0.03, 0, 0.03, 0.03, 0.06), cylinder="z"), 60, 1)
    world.run(0.05)
    return world


@test("a law, a force field and a motion in Python give the bits of the same functions in C")
def _():
    library = ctypes.CDLL(compiled("laws.so", LAWS, "-shared", "-fPIC", "-ffp-contract=off"))
    c = box_of(library.law, library.wind, library.shake)
    python = box_of(python_law, wind, shake)
    same(c.counters.contacts + c.counters.wall_contacts > 5, True, "there are contacts")
    same(python.hash, c.hash, "digest")


@test("a Python law may call the built-in laws and gets their bits")
def _():
    def law(c, memory, force):
        dem.law_hertz(c, memory, force)
        dem.law_spring(c, memory, force)
        dem.law_roll_epsd(c, dem.tail(memory, 3), force)

    def run(**more):
        world = dem.World(gravity=(0, 0, -9.81), dt=2e-5, **more)
        glass = world.material(density=2500, young=1e7, poisson=0.25, restitution=0.5, friction=0.5, rolling_friction=0.1)
        world.wall_plane(glass, (0, 0, 0), (0.1, 0, 1))
        world.spheres(glass, [(0, 0, 0.011), (0.015, 0.003, 0.012)], velocities=[(0.3, 0, 0), (0, 0, -0.2)], radius=0.01)
        world.run(0.03)
        return [list(body.position) + list(body.spin) for body in (world.body_id(0).state, world.body_id(1).state)]
    same(run(law=law, law_memory=6, law_vectors=2), run())


@test("an exception in a law, a force field, a motion, a region and a progress function reaches the caller")
def _():
    class Mine(Exception):
        pass

    def fail(*_):
        raise Mine("here")
    for more in ({"law": fail, "law_stiffness": 1e4}, {"force": fail}, {"body_force": fail}, {"body_reals": "heat", "body_reals_fn": fail}):
        world, glass = heap(**more)
        world.sphere(glass, 0.01, (0, 0, 0.0099))
        raises(Mine, lambda: world.run(0.1), "here")
        same(world.steps < 5, True, "steps until %s stopped" % list(more)[0])
    world, glass = heap()
    wall = world.wall_plane(glass, (0, 0, 5), (0, 0, -1))
    world.sphere(glass, 0.01, (0, 0, 1))
    raises(Mine, lambda: (wall.motion_set(kind="user", function=fail), world.run(0.1)), "here")
    world, glass = heap()
    raises(Mine, lambda: world.spheres_fill(glass, 0.01, dem.Region(box=(0, 0, 0, 1, 1, 1), inside=fail), 3, 1), "here")
    world.sphere(glass, 0.01, (0, 0, 3))
    raises(Mine, lambda: world.run(0.1, fail), "here")
    steps = world.steps
    world.run(0.01)                                         # the state is intact
    same(world.steps > steps, True, "the run goes on")
    output = world.output(function=fail, interval=0.001)
    raises(Mine, lambda: world.run(0.1), "here")
    output.remove()
    raises(Mine, lambda: world.trials_run(duration=0.01, budget=1, observables=[dem.Observable(name="x", function=fail)]), "here")


@test("a progress function that returns a number other than 0, and Ctrl-C, stop a run and leave it intact")
def _():
    world, glass = heap()
    world.sphere(glass, 0.01, (0, 0, 1))
    raises(dem.StoppedError, lambda: world.run(1e4, lambda world, done, left: done > 0), "stopped")
    import _thread
    timer = threading.Timer(0.2, _thread.interrupt_main)
    timer.start()
    raises(KeyboardInterrupt, lambda: world.run(1e4))
    world.run(0.01)


@test("Ctrl-C ends the runs of all threads within a second")
def _():
    code = ("import sys, os, signal, threading, time, concurrent.futures; sys.path.insert(0, %r); import dem\n"
            "def job(k):\n"
            "    world = dem.World(gravity=(0, 0, -9.81), threads=1)\n"
            "    glass = world.material(density=2500, young=1e7, poisson=0.25, restitution=0.5)\n"
            "    world.wall_plane(glass, (0, 0, 0), (0, 0, 1))\n"
            "    world.spheres_fill(glass, 2e-3, (-.02, -.02, 0, .02, .02, .2), 300, 1)\n"
            "    world.run(100)\n"
            "dem.load()\n"
            "began = []\n"
            "def interrupt():\n"
            "    began.append(time.time())\n"
            "    os.kill(os.getpid(), signal.SIGINT)\n"
            "threading.Timer(0.5, interrupt).start()\n"
            "try:\n"
            "    with concurrent.futures.ThreadPoolExecutor(2) as pool:\n"
            "        list(pool.map(job, range(4)))\n"
            "except KeyboardInterrupt:\n"
            "    print(time.time() - began[0])\n" % PYTHON)
    done = subprocess.run([sys.executable, "-B", "-c", code], capture_output=True, text=True, timeout=120)
    same(done.stderr, "")
    same(float(done.stdout) < 2, True, "s until all had ended: " + done.stdout)


@test("one world in two threads is refused by name, reads included; functions that the run calls may read")
def _():
    world, glass = heap(threads=1)
    world.spheres_fill(glass, 0.01, (-0.3, -0.3, 0, 0.3, 0.3, 0.4), 300, 1)
    body, seen = world.bodies[0], []

    def progress(world, *_):
        seen.append((world.time, body.state.position.z, len(world.bodies.positions), repr(world)))
        return stop.is_set()
    stop = threading.Event()
    thread = threading.Thread(target=lambda: swallow(lambda: world.run(1e4, progress)))
    thread.start()
    try:
        began = time.time()
        while not world._context.runs and time.time() - began < 5:
            time.sleep(0.01)
        raises(dem.Error, lambda: world.run(1), "World.run: another thread runs this world")
        raises(dem.Error, lambda: world.step(1), "another thread")
        raises(dem.Error, world.close, "another thread")
        for name in ("time", "steps", "hash", "totals", "contacts", "bodies_memory", "desc", "dt", "gravity", "counters"):
            raises(dem.ArgumentError, lambda: getattr(world, name), "World.", "another thread runs this world")
        raises(dem.ArgumentError, lambda: body.state, "Body.state: another thread runs this world")
        raises(dem.ArgumentError, lambda: world.bodies.positions, "another thread runs this world")
        raises(dem.ArgumentError, lambda: len(world), "another thread runs this world")
        raises(dem.ArgumentError, lambda: world.gravity_set((0, 0, -1)), "another thread runs this world")
        same(repr(world), "<World, run by another thread>")
    finally:
        stop.set()
        thread.join()
    same((len(seen) > 0, len(seen[0][3]) > 30), (True, True))
    world.run(1e-4)

    def law(contact, memory, force):                        # in all threads of OpenMP
        times.add(threaded.time)
        force.normal = 1e4*contact.overlap
    times = set()
    threaded = dem.World(law=law, law_stiffness=1e4, threads=2)
    glass = threaded.material(density=2500, young=1e7, poisson=0.25, restitution=0.5)
    threaded.spheres(glass, [(i*1.9e-3, j*1.9e-3, 0) for i in range(12) for j in range(12)], radius=1e-3)
    threaded.step(3)
    same(len(times) >= 2, True)


def swallow(function):
    try:
        function()
    except dem.StoppedError:
        pass


@test("functions of outputs and replays see the world, and a CSV file gets what they return")
def _():
    world, glass = heap()
    ball = world.sphere(glass, 0.01, (0, 0, 1))
    seen, path = [], os.path.join(WORK.name, "values.csv")

    def values(world, out):
        out[0] = ball.state.position.z
        out[1] = 7
    world.output(kind="csv", path=path, interval=0.01, columns="height seven", values=values)
    world.output(function=lambda world, number: seen.append((number, world.time)), interval=0.02)
    with world.replay(os.path.join(WORK.name, "r.html"), interval=0.01, number="height", number_fn=lambda world, body: body.of(world).state.position.z) as replay:
        world.run(0.1)
        replay.value_set("height (m)", 1)
    with open(path) as file:
        lines = file.read().split()
    same(lines[0], "time,height,seven")
    same(len(lines), 12)
    same(lines[1].split(",")[1:], ["1", "7"])
    same([number for number, _ in seen], [0, 1, 2, 3, 4, 5])
    same("<iframe" in replay._repr_html_(), True)


@test("numbers on bodies, wall parts, joints, polyhedra and grains from a file work")
def _():
    def exchange(c, memory, force):
        if c.who.b:                                         # no force: the spheres stay
            c.who.rate_a[0] = 5*(c.who.reals_b[0] - c.who.reals_a[0])
            c.who.rate_b[0] = 5*(c.who.reals_a[0] - c.who.reals_b[0])
    world = dem.World(law=exchange, law_stiffness=1e4, law_who=1, body_reals="heat")
    glass = world.material(density=2500, young=1e7, restitution=1)
    a, b = world.sphere(glass, 0.01, (0, 0, 0)), world.sphere(glass, 0.01, (0.0199, 0, 0))
    a.reals_set([1])
    world.run(1)
    near(a.reals[0] + b.reals[0], 1, 1e-9)
    near(a.reals[0], 0.5, 1e-3)
    same(world.bodies.reals.shape, (2, 1))
    world = dem.World(response="impulses", dt=1e-3, orientations=1)
    glass = world.material(density=2500)
    arm = world.sphere(glass, 0.1, (1, 0, 0))
    joint = world.joint(kind="revolute", a=arm, point=(0, 0, 0), axis=(0, 0, 1), motor="speed", speed=1)
    world.run(0.5)
    near(joint.state.turned, 0.5, 0.01)
    joint.motor_set("torque", 0, 0.1)
    joint.remove()
    world, glass = heap()
    shape = world.shape_polyhedron([(x, y, z) for x in (0, 0.01) for y in (0, 0.01) for z in (0, 0.01)])
    near(shape.info.volume, 1e-6, 1e-9)
    cube = world.body(glass, shape, (0, 0, 0.1))
    same(cube.state.shape, shape)
    grains = world.grains_parse("g.csv", "x y z r\n1 2 3 0.1\n4 5 6 0.2\n")
    same(grains.positions.tolist(), [[1, 2, 3], [4, 5, 6]])
    same(grains.velocities, None)
    world.grains(glass, grains)
    same(world.body_counts.present, 3)
    world.grains(None, world.grains_parse("g.csv", "x y z r material\n7 8 9 0.1 1\n"))     # of the materials in the file
    same(world.bodies.materials.tolist(), [glass.id]*4)
    mesh = dem.Mesh(vertices=[(0, 0, 0), (1, 0, 0), (0, 1, 0)], triangles=[(0, 1, 2)])
    world.mesh_place(mesh, 2, None, (0, 0, -1))
    same(mesh.vertices.tolist(), [[0, 0, -1], [2, 0, -1], [0, 2, -1]])
    out = io.StringIO()
    world.report(out)
    same(out.getvalue().startswith("dem.h "), True)
    same(dem.quat_rotate(dem.quat_about((0, 0, 1), math.pi), (1, 0, 0)).x, -1.0)
    field = world.field(box=(0, 0, 0, 1, 1, 1), cells=(2, 3, 4), interval=1e-5)
    world.step(10)
    same(field.data.momentum.shape, (24, 3))
    same([float(r) for r in world.sizes_draw(dem.Sizes(kind="uniform", min=1, max=2, by_count=1), 4, 0)][0] >= 1, True)


@test("slabs compute what the world computes, and worlds in two threads run side by side")
def _():
    def scene(seed):
        world, glass = heap(threads=1)
        world.spheres_fill(glass, 0.01, (-0.3, -0.3, 0, 0.3, 0.3, 0.4), 800, seed)
        return world
    alone, world = scene(1), scene(1)
    with world.slabs(axis=0, count=2) as slabs:
        slabs.step(200)
        slabs.collect(world)
    alone.step(200)
    same(world.steps, alone.steps)
    near(world.totals.kinetic, alone.totals.kinetic, 1e-9)
    begun = time.time()
    one = [scene(seed) for seed in (1, 2)]
    for each in one:
        each.step(150)
    alone_time = time.time() - begun
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        two = list(pool.map(scene, (1, 2)))
        begun = time.time()
        list(pool.map(lambda world: world.step(150), two))
    same([world.hash for world in two], [world.hash for world in one], "digests")
    print("# two worlds one after the other and side by side: %.2f s, %.2f s" % (alone_time, time.time() - begun))


@test("a checkpoint that Python writes continues bit for bit")
def _():
    path = os.path.join(WORK.name, "run.checkpoint")

    def scene():
        world, glass = heap()
        world.spheres_fill(glass, 0.01, (0, 0, 0, 0.1, 0.1, 0.2), 50, 1)
        return world
    first, second = scene(), scene()
    first.run(0.05)
    first.checkpoint_write(path)
    first.run(0.05)
    second.checkpoint_read_changed(path, "")
    same(second.checkpoint_changes, "")
    second.checkpoint_read(path)
    second.run(0.05)
    same(second.hash, first.hash)


@test("every function of a scene, from materials to checkpoints, can be called from Python")
def _():
    def at(name):
        return os.path.join(WORK.name, name)
    silent = io.StringIO()
    w, g = heap()
    s = w.material(density=7800, young=2e7, poisson=0.25, restitution=0.5, friction=0.3)
    w.pair_set(g, s, friction=0.1)
    same((w.pair(g, s).friction, w.pair(g, g).friction), (0.1, 0.5))
    near(w.coefficients(g, s, 1e-3, 0).r_eff, 1e-3)
    w.pairs_print(silent)
    g.set(friction=0.4)
    same((g.desc.friction, g.desc.young), (0.4, 1e7))
    plane = w.wall_plane(g, (0, 0, 0), (0, 0, 1))
    w.wall_cone(g, (0, 0, -1), (0, 0, -2), 0.1, 0.2)
    w.wall_revolved(g, (0, 0, -5), (0, 0, 1), [0.1, 0.2], [0, 0.1])
    sieve = w.wall_sieve(g, kind="square", point=(0, 0, -3), aperture=0.01, bar=0.01, thickness=0.002)
    w.wall_grains(g, [(0, 0, -4), (0, 0.1, -4)], 0.01, 1)
    cluster = w.shape_cluster(positions=[(0, 0, 0), (0.001, 0, 0)], radius=0.001)
    same(cluster.info.spheres, 2)
    cube = w.shape_polyhedron([(x, y, z) for x in (0, 0.01) for y in (0, 0.01) for z in (0, 0.01)])
    w.body(g, w.shape_union([cube, cube], [(0, 0, 0), (0.01, 0, 0)]), (0, 0, 0.5))
    w.bodies_add(g, cluster, [(0, 0, 0.2), (0, 0, 0.3)], scales=[1, 2])
    same(w.bodies_fill(g, cluster, (-0.1, -0.1, 0.6, 0.1, 0.1, 0.8), 5, 1), 5)
    sizes = dem.Sizes(kind="lognormal", median=0.002, spread=0.1)
    same(w.sizes_fill(g, sizes, (-0.1, -0.1, 0.8, 0.1, 0.1, 1), 5, 1), 5)
    near(sum(w.sizes_classes(sizes, 4)[1]), 1)
    near(w.sizes_finer(sizes, 0.002), 0.5)
    same(len(w.sizes_draw(dem.Sizes(kind="sieve_curve", radius=[0.001, 0.002, 0.003], passing=[0, 0.5, 1]), 3, 0)), 3)
    same(w.spheres_pack(g, 0.002, 0, (-0.01, -0.01, 1.2, 0.01, 0.01, 1.3), 10), 10)
    feed = w.feed(material=g, radius=[1e-3, 2e-3], amount=[3, 4], limited=1, rate=1e5, box=(-0.05, -0.05, 1.5, 0.05, 0.05, 1.6),
                  sizes=[None, dem.Sizes(kind="uniform", min=1e-3, max=2e-3)])
    outlet = w.outlet(box=(-1, -1, 1.49, 1, 1, 1.7), keep=1, radius=[1e-3], residence_bin=0.1)
    plane.motion_set(kind="table", table=[dem.MotionRow(0, (0, 0, 0)), dem.MotionRow(1, (0, 0, 0.001))])
    lid = w.wall_plane(g, (0, 0, 3), (0, 0, -1))
    rider = w.sphere(g, 0.001, (0, 0, 2.5))
    rider.rail_set(axes=63)
    same(rider.reaction.desc.axes, 63)
    rider.rail_set(axes=0)
    rider.remove()
    lid.surface_velocity_set((0.5, 0, 0))
    near(lid.surface_velocity[0], 0.5)
    lid.surface_velocity_set((0, 0, 0))
    lid.motion_set(kind="servo", velocity=(0, 0, -0.1), load=1)
    field = w.field(box=(-1, -1, 0, 1, 1, 1), cells=(2, 2, 2), stress=1, interval=1e-5, variance=1, bodies=1)
    w.run(0.002)
    same(lid.servo.target, 1)
    same((feed.state.total, outlet.state.total >= 0, sum(feed.state.fed)), (7, True, 7))
    outlet.reset()
    means = w.body_id(0).means
    same((means.samples > 0, len(means.force)), (True, 3))
    mixing = w.mixing(box=(-1, -1, -9, 1, 1, 9), cells=(2, 2, 2), radius_max=0.0015)
    same((mixing.part > 0, mixing.grains > mixing.part, -1 <= mixing.segregation[2] <= 1), (True, True, True))
    for name in ("bodies_csv", "contacts_csv"):
        getattr(w, name + "_write")(at(name))
        same(os.path.getsize(at(name)) > 40, True, name)
    field.csv_write(at("field.csv"))
    outlet.residence_csv_write(at("residence.csv"))
    same(os.path.getsize(at("field.csv")) > 100 and os.path.getsize(at("residence.csv")) > 20, True)
    same((field.data.stress.shape, field.cell(0, 0, 0).density >= 0), ((8, 6), True))
    field.reset()
    same(w.step_advice.dt > 0 and w.totals.mass > 0 and w.error == "", True)
    w.candidates_rebuild()
    same((len(w.candidates) >= len(w.contacts) - 20, w.contacts_each(lambda contact, memory: None) >= 0, w.sieve_blinded(sieve)), (True, True, 0))
    raises(dem.Error, lambda: w.bonds_make(-1, lambda contact, memory: None), "dem_bonds_make")
    raises(dem.ArgumentError, lambda: w.repose_heap(), "dem_repose_heap_get")
    raises(dem.ArgumentError, lambda: w.repose_drum(None, (0, 1, 0)), "dem_repose_drum_get")
    near(w.observer_kinetic(), w.totals.kinetic + w.totals.rotational)
    same(w.observer_height() > 0 and w.observer_contacts() >= 0 and w.observer_walls() >= 0, True)
    for name in ("vtp", "vtk", "xyz", "contacts_vtp", "surfaces_vtp"):
        getattr(w, name + "_write")(at(name))
        same(os.path.getsize(at(name)) > 100, True, name)
    w.walls_vtp_write(at("walls"), 0, 1)
    plane.loads_csv_write(at("loads.csv"))
    same((plane.pose.rotation[0], plane.loads.contacts), (1.0, 0))
    plane.loads_reset()
    with open(at("parts.obj"), "w") as file:
        file.write("o a\nv 0 0 -9\nv 1 0 -9\nv 0 1 -9\nf 1 2 3\no b\nf 1 2 3\n")
    same(w.mesh_part_read(at("parts.obj"), "a")[0].triangle_count, 1)
    part = w.wall_parts(at("parts.obj"), 1, [dem.WallPart(name="a", material=g, motion=dem.Motion(kind="user", function=lambda t, pose: None))])[0]
    with open(at("cube.obj"), "w") as file:
        file.write("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                   "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n")
    mesh, health = w.mesh_read(at("cube.obj"))
    positions, radii, fit = w.mesh_spheres(mesh, 3)
    same((len(positions), len(radii), round(fit.volume, 9), health.open_edges), (3, 3, 1.0, 0))
    same(w.shape_mesh(mesh).info.corners, 8)
    w.wall_mesh(s, dem.Mesh(vertices=[(0, 0, -8), (1, 0, -8), (0, 1, -8)], triangles=[(0, 1, 2)])).remove()
    with open(at("profile"), "w") as file:
        file.write("2 1\n0 0\n1 0\n1 2\n")
    w.wall_profile(g, w.profile_read(at("profile"))).remove()
    same(w.profile_read(at("profile")).segments.tolist(), w.profile_parse("text", "2 1\n0 0\n1 0\n1 2\n").segments.tolist())
    with open(at("grains.csv"), "w") as file:
        file.write("x y z r\n1 2 3 0.1\n")
    same(w.grains_read(at("grains.csv")).count, 1)
    same([effect.name for effect in w.effects()][0], "contacts")
    w.effects_print(out=silent)
    same(len(w.check()) >= 0 and w.check_print(silent) >= 0, True)
    w.output_every("vtp", at("out_####.vtp"), 0.001).remove()
    w.gravity_set((0, 0, -1))
    same(w.desc.gravity.z, -1.0)
    w.temperature_set(1e-4, 1)
    near(w.temperature, 1e-4)
    raises(dem.StoppedError, lambda: w.settle(1e-4), "dem_world_settle")
    with contextlib.redirect_stderr(silent):
        w.run_to(w.time + 1e-5, dem.progress_print)
    w.overlap_max_reset()
    w.body_id(0).radius_set(w.body_id(0).state.radius)
    w.body_id(0).remove()
    part.remove()
    same(w.body_counts.removed, 2)
    sets = dem.World(groups="one two")
    m = sets.material(density=2500, young=1e7, poisson=0.25, restitution=0.5)
    sets.spheres(m, [(0, 0, 0), (1, 0, 0), (2, 0, 0)], radius=0.1)
    some = dem.Selection(region=dem.Region(box=((0.5, -1, -1), (3, 1, 1))))
    same(sets.bodies_group_set(some, sets.group("two"), 1), 2)
    two = dem.Selection(group=sets.group("two"))
    same([body.slot for body in sets.bodies_select(two)], [2, 3])
    same((sets.bodies_velocity_set(two, (1, 0, 0), (0, 0, 0)), sets.bodies_fixed_set(two, 0)), (2, 2))
    means = sets.bodies_means(group=sets.group("two"))
    same((means.bodies, means.velocity[0]), (2, 1.0))
    same(sets.bodies_remove(group=sets.group("two")), 2)
    numbers = dem.World(body_reals="heat")
    glass = numbers.material(density=2500, young=1e7, restitution=1)
    floor = numbers.wall_plane(glass, (0, 0, 0), (0, 0, 1))
    floor.reals_set([4])
    numbers.sphere(glass, 0.01, (0, 0, 1))
    numbers.bodies_reals_set([[3]])
    same((floor.reals[0], numbers.bodies.reals.tolist()), (4.0, [[3.0]]))
    counted, seen = dem.World(ledger=1, gravity=(0, 0, -10)), []
    glass = counted.material(density=2500, young=1e7, restitution=0.5, friction=0.3)
    floor = counted.wall_mesh(glass, dem.Mesh(vertices=[(-1, -1, 0), (1, -1, 0), (0, 1, 0)], triangles=[(0, 1, 2)]))
    counted.sphere(glass, 0.01, (0, 0, 0.011))
    counted.events_record(function=lambda event: seen.append((event.kind, event.wall, event.closing_speed)), begins=1)
    counted.run(0.05)
    same((len(seen) >= 2, seen[0][:2], seen[1][:2]), (True, (dem.EventKind.BEGIN, 1), (dem.EventKind.END, 1)))
    near(seen[0][2], (2*10*0.001)**0.5, 0.02)
    impacts = counted.impacts(glass, glass)
    same((impacts.ended, counted.events_open_each()), (sum(kind == dem.EventKind.END for kind, _, _ in seen), len(seen) % 2))
    near(impacts.lost_normal, counted.ledger.normal, 1e-9)
    same((counted.impacts() == impacts, counted.impacts(glass, None) == impacts), (True, True), "impacts of any materials")
    same((floor.wear(1e-4, 1e9).slide, list(floor.wear_facets)), (counted.ledger.slide, [counted.ledger.slide]))
    counted.impacts_csv_write(at("impacts.csv"))
    counted.events_stop()
    contact = dem.ellipsoids_contact(dem.Ellipsoid((0, 0, 0), (1, 1, 1)), dem.Ellipsoid((1.9, 0, 0), (1, 1, 1)))
    near(contact.scale, 0.95)
    same(dem.result_name(dem.Result.ERROR_FILE), "file error")
    same(dem.quat_unrotate(dem.quat_multiply((1, 0, 0, 0), (1, 0, 0, 0)), (1, 2, 3)), (1, 2, 3))
    cell = dem.World(domain=(0, 0, 0, 0.1, 0.1, 0.1), boundary=["periodic"]*3)
    cell.sphere(cell.material(density=2500, young=1e7, restitution=0.5), 0.01, (0.05, 0.05, 0.05))
    cell.cell_set(rate=(-1, 0, 0), shear=2)
    cell.run(0.01)
    near(cell.cell_state.strain[0], -0.01, 0.02)
    near(cell.stress.volume, 1e-3*(1 + cell.cell_state.strain[0]), 1e-3)
    flat = dem.World(planar=1)
    same(flat.material(density=1, young=1, restitution=1).world.shape_polygon([(0, 0), (1, 0), (0, 1)]).info.volume, 0.5)
    ball = dem.World()
    same(ball.shape_ellipsoid((1, 2, 3)).info.semi_axes.z, 3.0)
    small, glass = heap()
    small.spheres_fill(glass, 0.01, (0, 0, 0, 0.1, 0.1, 0.1), 10, 1)
    dem.trials_print(small.trials_run(duration=0.01, budget=1), silent)
    slabs = small.slabs(axis=0, count=2)
    same((sum(slabs.slab(i).grains for i in range(2)), slabs.counters.steps, slabs.error), (10, 0, ""))
    slabs.loads_reset()
    with small.replay(at("frames.html")) as replay:
        replay.frame_write()
    force, given = dem.ContactForce(), dem.Contact(overlap=1e-4, kn=1e5, kt=1e5, ct=1, kun=2e5, r_eff=0.01, m_eff=1e-3, dt=1e-5,
                                                   slip=(0.1, 0, 0), normal=(0, 0, 1), friction=0.5, friction_static=0.5)
    memory = (dem.Real*8)()
    for law in ("hertz", "linear", "hysteretic", "viscous", "step", "mindlin", "mindlin_rescaled", "roll_step", "roll_constant", "twist"):
        getattr(dem, "law_" + law)(given, memory, force)
    dem.law_load(given, force, 0)
    same(force.normal > 0 and dem.memory_rotate(given, (1, 0, 0)).x == 1, True)


# ---- what a user sees first ----

@test("after an exception in a function and after Ctrl-C only the exception is printed, and no later run quotes dem.h")
def _():
    code = ("import sys, threading, _thread; sys.path.insert(0, %r); import dem\n"
            "def fail(*_): raise KeyError('mine')\n"
            "kind = sys.argv[1]\n"
            "more = {'law': dict(law=fail, law_stiffness=1e4), 'law on 2 threads': dict(law=fail, law_stiffness=1e4, threads=2)}\n"
            "more = more.get(kind, {kind: fail} if kind in ('force', 'body_force', 'growth') else {})\n"
            "with dem.World(gravity=(0, 0, -9.81), **more) as world:\n"
            "    glass = world.material(density=2500, young=1e7, poisson=0.25, restitution=0.5)\n"
            "    wall = world.wall_plane(glass, (0, 0, 0), (0, 0, 1))\n"
            "    world.sphere(glass, 0.01, (0, 0, 0.0099))\n"
            "    if kind == 'motion': wall.motion_set(kind='user', function=fail)\n"
            "    if kind == 'output': world.output(function=fail, interval=1e-3)\n"
            "    if kind == 'trials':\n"
            "        world.trials_run(duration=0.01, budget=1, observables=[dem.Observable(name='x', function=fail)])\n"
            "    if kind == 'interrupt': threading.Timer(0.1, _thread.interrupt_main).start()\n"
            "    world.run(1e3 if kind == 'interrupt' else 0.1, fail if kind == 'progress' else None)\n" % PYTHON)
    for kind in ("law", "law on 2 threads", "force", "body_force", "growth", "motion", "output", "progress", "trials", "interrupt"):
        done = subprocess.run([sys.executable, "-B", "-c", code, kind], capture_output=True, text=True, timeout=60)
        same((done.stderr.rstrip().split("\n")[-1], "dem.h:" in done.stderr), ("KeyboardInterrupt" if kind == "interrupt" else "KeyError: 'mine'",
                                                                             False), kind + ": " + done.stderr[-300:])

    def fail(*_):
        raise KeyError("mine")
    world, glass = heap()
    wall = world.wall_plane(glass, (0, 0, 5), (0, 0, -1))
    raises(KeyError, lambda: wall.motion_set(kind="user", function=fail))
    world.run(0.001)                                        # the message of dem_wall_motion_set has been read


@test("arguments that do not fit raise a TypeError that is a dem.Error: misspelled, without a name, missing, too many")
def _():
    world, glass = heap()
    ball = world.sphere(glass, 0.01, (0, 0, 0.1))
    contact, force = dem.Contact(), dem.ContactForce()
    for call, *words in ((lambda: world.material(density=1, restituion=0.5), "World.material: there is no argument 'restituion'", "restitution"),
                         (lambda: world.material(2500, 1e7), "World.material: 2500, 10000000.0 are given without a name", "density=..."),
                         (lambda: dem.World(garvity=(0, 0, 1)), "World: there is no argument 'garvity'; did you mean gravity?"),
                         (lambda: dem.World((0, 0, 1)), "World: (0, 0, 1) is given without a name", "gravity=..."),
                         (lambda: world.sphere(glass, raduis=1, position=(0, 0, 1)), "World.sphere: ", "'raduis'", "radius"),
                         (lambda: world.sphere(glass, 0.01), "World.sphere: position is missing", "(material, radius, position)"),
                         (lambda: world.sphere(glass, 0.01, (0, 0, 1), 5), "World.sphere: 4 arguments are given, it takes 3"),
                         (lambda: world.sphere(glass, 0.01, radius=1, position=(0, 0, 1)), "World.sphere: radius is given twice"),
                         (lambda: world.run(), "World.run: seconds is missing"), (lambda: world.run(1, 2, 3), "at most 2"),
                         (lambda: world.run(secs=1), "World.run: ", "'secs'", "seconds"), (lambda: world.close(5), "World.close: 1 argument"),
                         (lambda: ball.set(velocty=(0, 0, 1)), "Body.set: ", "'velocty'", "did you mean velocity?"),
                         (lambda: ball.set((0, 0, 1)), "Body.set: (0, 0, 1) is given without a name"),
                         (lambda: glass.set(fricton=1), "Material.set: ", "friction"), (lambda: ball.of(), "Body.of: world is missing"),
                         (lambda: world.wall_plane(glass, (0, 0, 0)), "World.wall_plane: normal is missing"),
                         (lambda: world.bodies.to_dict(1), "Rows.to_dict: 1 argument is given, it takes none"),
                         (lambda: dem.Motion(sped=1), "Motion has no field 'sped'", "did you mean speed?"),
                         (lambda: dem.Vec3.make(), "Vec3.make: value is missing"), (lambda: dem.Vec3().dot(), "Vec3.dot: other is missing"),
                         (lambda: dem.law_spring(contact, force), "dem.law_spring: f is missing", "(c, memory, f)"),
                         (lambda: dem.law_hertz(contact, force=force), "dem.law_hertz: ", "'force'"),
                         (lambda: dem.compile("", flag=1), "dem.compile: ", "'flag'", "flags"), (lambda: dem.Page(), "Page: path is missing"),
                         (lambda: dem.quat_about(), "dem.quat_about: axis, angle are missing"), (lambda: dem.tail(), "dem.tail: ")):
        same(isinstance(raises(TypeError, call, *words), dem.Error), True, words[0])

    def wrong():
        return (lambda a: a)()                              # a TypeError inside of a call stays
    raises(TypeError, lambda: world.run(0.001, lambda *_: wrong()), "missing 1 required positional argument: 'a'")
    for function in (dem.World.material, dem.World.sphere, dem.Body.set, dem.law_spring, dem.World.__init__):
        same("fields" in str(inspect.signature(function)) or "values" in str(inspect.signature(function)), False, "signature")
    same(list(inspect.signature(dem.World.sphere).parameters), ["self", "material", "radius", "position"])


@test("nothing that a call returned or that a function may only read can be changed: fields, arrays, elements, vectors")
def _():
    import pickle
    world, glass = heap()
    world.spheres(glass, [(0, 0, 0.0099), (0.019, 0, 0.0099)], radius=0.01)
    world.step(1)
    for change, *words in ((lambda: world.totals.centre.__setitem__(0, 9), "array[0]"), (lambda: world.totals.centre.__setitem__(slice(0, 2), [1, 2]),),
                           (lambda: setattr(world.contacts[0], "overlap", 1), "ContactInfo.overlap"), (lambda: setattr(world.effects()[0], "text", 1),),
                           (lambda: setattr(world.contacts[0].normal, "x", 1), "Vec3.x"), (lambda: setattr(world.gravity, "z", 1), "world.gravity = ("),
                           (lambda: world.cell_state.rate.__setitem__(0, 1), "array[0]"), (lambda: setattr(world.gravity, "z", 1), "Vec3.z")):
        same(isinstance(raises(AttributeError, change, *words), dem.Error), True)
    means = copy.copy(world.totals)
    means.centre[0] = 9                                     # of a copy
    same(means.centre[0], 9.0)
    feed = dem.FeedDesc(radius=[1, 2], amount=[1, 2])
    feed.radius[0] = 5                                      # of a struct that the user made
    same(list(feed.radius[:2]), [5, 2])
    seen = []

    def law(c, memory, force):
        for change in (lambda: setattr(c, "overlap", 0), lambda: setattr(c.normal, "x", 0), lambda: setattr(c.who, "a", dem.Body())):
            seen.append(str(raises(AttributeError, change, "a function may only read it")))
        kept = copy.copy(c)
        kept.overlap = 7
        same((type(kept), kept.overlap, type(pickle.loads(pickle.dumps(c))), kept == c, repr(c)[:8]), (dem.Contact, 7.0, dem.Contact, False, "Contact("))
        force.normal = 1e4*c.overlap

    def lift(body, id, time, force, torque):
        raises(AttributeError, lambda: setattr(body.velocity, "x", 0), "a function may only read it")
        force.z = 1
    def heat(reals, rates, body, id, time, dt):
        raises(AttributeError, lambda: rates.__setitem__(0, 1.0), "a function may only read it")
        raises(IndexError, lambda: rates[1], "numbers 0 to 0")
        reals[0] = rates[0] + 1
    warm, glass = heap(body_reals="heat", body_reals_fn=heat)
    warm.sphere(glass, 0.01, (0, 0, 0.5))
    warm.step(2)
    same(warm.bodies.reals.tolist(), [[1]])
    other, glass = heap(law=law, law_stiffness=1e4, body_force=lift)
    other.sphere(glass, 0.01, (0, 0, 0.0099))
    other.step(2)
    same(len(seen) >= 3, True)


@test("arrays of structs and views of numbers are pickled, and a process may return them")
def _():
    import pickle
    world, glass = heap(body_reals="heat")
    world.spheres(glass, [(0, 0, 0.0099), (0.019, 0, 0.0099)], radius=0.01)
    world.step(1)
    mesh = dem.Mesh(vertices=[(0, 0, 0), (1, 0, 0), (0, 1, 0)], triangles=[(0, 1, 2)])
    table = dem.Motion(kind="table", table=[dem.MotionRow(0, (0, 0, 0)), dem.MotionRow(1, (0, 0, 1))]).table
    for thing in (world.contacts, world.bodies.positions, world.bodies.masses, world.bodies.slots, world.bodies_memory.velocities, mesh.vertices,
                  mesh.triangles, world.totals.centre, world.candidates, table, world.body_id(0).reals, world.bodies.positions[1],
                  world.bodies.positions[:, 2], world.bodies.positions[:, :3]):
        for made in (pickle.loads(pickle.dumps(thing)), copy.copy(thing), copy.deepcopy(thing)):
            same((made == thing, len(made), repr(made)), (True, len(thing), repr(thing)))
    same(pickle.loads(pickle.dumps(world.contacts)).to_dict(), world.contacts.to_dict())
    same(len(pickle.loads(pickle.dumps(heap()[0].bodies.to_dict()))["x"]), 0)


@test("arrays are indexed and iterated by rows without numpy, and wrong indices raise by name")
def _():
    world, glass = heap()
    world.spheres(glass, [(0.1*i, 0, 1) for i in range(5)], radius=0.01)
    p = world.bodies.positions
    same((p[1].tolist(), [x for x, y, z, radius in p], p[-1, 2], len(p), p.shape), ([0.1, 0, 1, 0.01], [0.1*i for i in range(5)], 1.0, 5, (5, 4)))
    same((p[1:3].tolist(), p[:, 0].tolist(), p[::2].shape, p[:, :3].shape, p[1, :2].tolist()), (
        p.tolist()[1:3], [0.1*i for i in range(5)], (3, 4), (5, 3), [0.1, 0]))
    same((p == p.tolist(), p == world.bodies.positions, world.bodies.masses[1:].shape, sum(world.bodies.masses) > 0), (True, True, (4,), True))
    for call, *words in ((lambda: p[5], "5", "(5, 4)"), (lambda: p[0, 4], "(0, 4)", "(5, 4)"), (lambda: p["a"], "'a'"), (lambda: p[0, 0, 0], "2 axes"),
                         (lambda: p.mean, "mean", "numpy.asarray"), (lambda: p.__setitem__((0, 0), 1), "read-only"),
                         (lambda: world.totals.centre[3], "numbers 0 to 2"), (lambda: world.totals.centre["a"],)):
        raises(dem.Error, call, *words)
    raises(TypeError, lambda: p.__setitem__(0, (1, 2, 3, 4)))
    mesh = dem.Mesh(vertices=[(0, 0, 0), (1, 0, 0), (0, 1, 0)], triangles=[(0, 1, 2)])
    mesh.vertices[0] = (1, 2, 3)
    mesh.vertices[1, 2] = 9
    same(mesh.vertices.tolist(), [[1, 2, 3], [1, 0, 9], [0, 1, 0]])
    raises(ValueError, lambda: mesh.vertices.__setitem__(0, (1, 2)), "(1, 2)")
    world.bodies.positions = p[:, :3]
    same(world.bodies.positions == p, True)
    same("0.1" in repr(p) and repr(world.totals.centre)[0] == "[", True)


@test("a contact history, columns and numbers of bodies are not used beyond their end: the message says what there is")
def _():
    for memory, text in ((3, "numbers 0 to 2"), (0, "no numbers")):
        world, glass = heap(law=lambda c, memory, force: memory[3], law_stiffness=1e4, law_memory=memory)
        world.sphere(glass, 0.01, (0, 0, 0.0099))
        same(isinstance(raises(IndexError, lambda: world.step(1), "your function (law)", text, "law_memory"), dem.Error), True)
    world, glass = heap()
    world.output(kind="csv", path=os.path.join(WORK.name, "beyond.csv"), columns="a b", interval=1e-3,
                 values=lambda world, out: out.__setitem__(5, 1.0))
    raises(IndexError, lambda: world.run(0.01), "your function", "numbers 0 to 1", "columns")
    world, glass = heap(law=lambda c, memory, force: [][3], law_stiffness=1e4)
    world.sphere(glass, 0.01, (0, 0, 0.0099))
    raises(IndexError, lambda: world.step(1), "list index out of range")


@test("an array with the radius in column 4 is refused with the remedy; only an array that fits then is to be transposed")
def _():
    world, glass = heap()
    world.spheres(glass, [(0.1*i, 0, 1) for i in range(3)], radius=0.01)
    p = world.bodies.positions
    for array in (p, p.tolist()):
        text = str(raises(ValueError, lambda: setattr(world.bodies, "positions", array), "leave out"))
        same("transpose" in text, False, text)
    raises(ValueError, lambda: world.spheres(glass, p, radius=0.01), "leave out column 4: array[:, :3]")
    for shape, fits in (([3, 6], True), ([6, 2], False)):
        view = memoryview((ctypes.c_double*(shape[0]*shape[1]))()).cast("B").cast("d", shape)
        same("transpose" in str(raises(ValueError, lambda: world.spheres(glass, view, radius=0.01))), fits)
        same("transpose" in str(raises(ValueError, lambda: setattr(world.bodies, "positions", view))), False)


@test("a world without bodies gives empty columns")
def _():
    columns = dem.World(body_reals="heat").bodies.to_dict()
    same((columns["x"], columns["mass"], columns["material"], columns["heat"], len(columns)), ([], [], [], [], 16))


@test("a world whose bodies are all removed gives what a new world gives: None for each array")
def _():
    for more in ({}, {"body_reals": "age heat", "groups": "a b"}):
        world, glass = heap(**more)
        world.sphere(glass, 1e-3, (0, 0, 0.1)).remove()
        for name in dem.Bodies.kinds:
            if name not in ("count", "real_count"):
                same(getattr(world.bodies, name), None, name)
                if name != "groups":
                    same(getattr(world.bodies_memory, name), None, name)
        same(world.bodies.to_dict()["x"], [])
        world.sphere(glass, 1e-3, (0, 0, 0.1))
        same(world.bodies.positions.shape, (1, 4))


@test("+=, -=, *=, /= and v[i] = x change a vector where it may be changed, also the force of a function, and raise elsewhere")
def _():
    v = dem.Vec3(1, 2, 3)
    w = v
    v += (1, 1, 1)
    v -= dem.Vec3(0, 1, 0)
    v *= 4
    v /= (2, 4, 8)
    v[0] += 1
    v[-1] = 7
    same((v is w, tuple(v)), (True, (5, 2, 7)))
    raises(IndexError, lambda: v.__setitem__(3, 1), "Vec3[...]: 3")
    raises(TypeError, lambda: v.__setitem__(1, "x"), "Vec3.y", "'x'")
    raises(TypeError, lambda: v.__iadd__((1, 2)), "Vec3 += ...", "3 numbers are wanted")
    raises(TypeError, lambda: v.__imul__("abc"), "Vec3 *= ...")
    ramp = dem.Motion()
    ramp.velocity += (0, 0, 1)
    ramp.velocity[1] = 2
    same(tuple(ramp.velocity), (0, 2, 1))

    def first(body, id, time, force, torque):
        force += (0, 0, 1e-6)
        force[2] += 1e-6
        torque -= (1e-9, 0, 0)
        torque *= 2

    def second(body, id, time, force, torque):
        force.z, torque.x = 1e-6 + 1e-6, 2*(0 - 1e-9)
    hashes = []
    for function in (first, second):
        world = dem.World(body_force=function)
        ball = world.sphere(world.material(density=2500, young=1e7, poisson=0.25, restitution=0.5), 1e-3, (0, 0, 0.1))
        world.step(10)
        assert ball.state.velocity.z > 0 and ball.state.spin.x < 0
        hashes.append(world.hash)
    same(hashes[0], hashes[1])
    raises(dem.FieldError, lambda: ball.state.velocity.__iadd__((0, 0, 1)), "Vec3 += ...", "Body.set(")
    raises(dem.FieldError, lambda: ball.state.velocity.__setitem__(0, 1), "Body.set(")

    def wrong(body, id, time, force, torque):
        body.velocity += (0, 0, 1)
    world = dem.World(body_force=wrong)
    world.sphere(world.material(density=2500, young=1e7, poisson=0.25, restitution=0.5), 1e-3, (0, 0, 0.1))
    raises(dem.FieldError, lambda: world.step(1), "Vec3 += ...", "may only read")
    world = dem.World()
    world.gravity += (0, 0, -1)
    same(tuple(world.gravity), (0, 0, -1))

    def law(contact, memory, force):
        force.normal = 1.0
        force.tangent[0] = 1
        force.tangent += (0, 2, 0)
        found.append(tuple(force.tangent))
    found = []
    world = dem.World(law=law, law_stiffness=1e3)
    glass = world.material(density=2500, young=1e7, poisson=0.25, restitution=0.5)
    world.wall_plane(glass, (0, 0, 0), (0, 0, 1))
    world.sphere(glass, 1e-3, (0, 0, 0.99e-3))
    world.step(1)
    assert found and found[0][1] == 2, found
    row = dem._row(dem.Real, 3)(1, 2, 3)
    row += 1
    same(list(row), [2, 3, 4])


@test("after a law or a force field has raised, later calls say so first, with the step")
def _():
    for kind in ("law", "force", "body_force"):
        armed = []

        def fails(*arguments):
            if armed:
                raise RuntimeError("mine")
            return (0, 0, 0) if kind == "force" else None
        world, glass = heap(**{"law_stiffness": 1e3, "law": fails} if kind == "law" else {kind: fails})
        world.sphere(glass, 0.01, (0, 0, 0.0099))
        world.step(3)
        armed.append(1)
        raises(RuntimeError, lambda: world.step(1), "mine")
        armed.clear()
        text = str(raises(dem.UnstableError, lambda: world.run(0.1), "your function (%s) raised at step " % kind, "of this world; "
                          "read a checkpoint or build it again"))
        assert text.index("your function") < 20 and int(text.partition("at step ")[2].split()[0]) in (3, 4), text


@test("an assignment to a field of world.desc or to the pose of a wall names the call that sets it")
def _():
    world, glass = heap()
    wall = world.wall_plane(glass, (0, 0, 1), (0, 0, -1))
    for call, word in ((lambda: setattr(world.desc, "gravity", (0, 0, 1)), "write world.gravity = ..."),
                       (lambda: setattr(world.desc.gravity, "x", 1), "write world.gravity = ..."),
                       (lambda: setattr(world.desc, "dt", 1), "write world.dt = ..."),
                       (lambda: setattr(world.desc, "threads", 1), "dem.World(threads=...)"),
                       (lambda: setattr(wall.pose, "position", (0, 0, 1)), "wall.motion_set(...)"),
                       (lambda: setattr(wall.pose.position, "x", 1), "wall.motion_set(...)")):
        raises(dem.FieldError, call, word)


@test("dem.Page refuses what is not a replay, and a height that is no whole number above 0; DEM_REAL takes float or double")
def _():
    path = os.path.join(WORK.name, "page.html")
    world, glass = heap()
    world.sphere(glass, 0.01, (0, 0, 0.02))
    with world.replay(path) as replay:
        replay.frame_write()
    same((dem.Page(path, 300).height, repr(dem.Page(path))), (300, "dem.Page(%r)" % path))
    for height in (0, -1, 1.5, "560", None):
        raises(dem.Error, lambda: dem.Page(path, height), "dem.Page: height: ")
    raises(dem.FormatError, lambda: dem.Page(__file__), "dem.Page", "not a replay")
    raises(dem.FileError, lambda: dem.Page(path + "l"), "dem.Page: cannot read")
    for value in ("single", "Float"):
        result = subprocess.run([sys.executable, "-c", "import dem"], cwd=PYTHON, env=dict(os.environ, DEM_REAL=value),
                                capture_output=True, text=True)
        assert "LoadError" in result.stderr and "DEM_REAL is %r" % value in result.stderr, result.stderr


@test("messages name what is wanted: Selection, Grains, the array, the kind of a function, numbers on bodies, one radius, numpy")
def _():
    world, glass = heap(groups="a b")
    ball = world.sphere(glass, 0.01, (0, 0, 0.02))
    group = world.group("a")
    for bodies in ([ball], ball, world.bodies):
        raises(TypeError, lambda: world.bodies_group_set(bodies, group, 1), "World.bodies_group_set: selection: ", "dem.Selection(bodies=[...])")
        raises(TypeError, lambda: world.bodies_fixed_set(bodies, 1), "World.bodies_fixed_set: selection: ", "dem.Selection(bodies=[...])")
    same(world.bodies_group_set(dem.Selection(bodies=[ball]), group, 1), 1)
    raises(TypeError, lambda: world.grains(glass, [(0, 0, 1, 0.01)]), "World.grains: grains: ", "a Grains is wanted", "world.spheres")
    bodies = world.bodies
    raises(TypeError, lambda: bodies.velocities.__setitem__((0, 0), 1), "world.bodies.velocities = array")
    raises(TypeError, lambda: bodies.masses.__setitem__(0, 1), "body.radius_set")
    for call in (ball.reals_set, world.bodies_reals_set):
        raises(ValueError, lambda: call([1]), "this world has no numbers on bodies", "dem.World(body_reals=")
    raises(ValueError, lambda: world.spheres(glass, [(0, 0, 1)], radii=[0.01], radius=0.02), "World.spheres: radii and radius are given")
    raises(ValueError, lambda: world.shape_cluster(positions=[(0, 0, 0)], radii=[0.01], radius=0.02), "World.shape_cluster: radii and radius")
    for call in (lambda a: a - a, lambda a: a*2, lambda a: 2*a, lambda a: a + 1, lambda a: -a, lambda a: a - [1]):
        raises(dem.ArgumentTypeError, lambda: call(bodies.positions), "numpy.asarray(a) - ...")

    class Numpy:
        def __array__(self):
            raise AssertionError

        def __rsub__(self, other):
            return "numpy"
    same(bodies.positions - Numpy(), "numpy")
    same(tuple(dem.Vec3.make(memoryview((ctypes.c_int*3)(1, 2, 3)))), (1, 2, 3))
    world.spheres(glass, memoryview((ctypes.c_int*3)(0, 0, 1)), radius=0.01)
    kept = []

    def law(contact, memory, force):
        kept.append(contact)
    world = dem.World(law=law, law_stiffness=1e3)
    glass = world.material(density=2500, young=1e7, poisson=0.25, restitution=0.5)
    world.wall_plane(glass, (0, 0, 0), (0, 0, 1))
    world.sphere(glass, 0.01, (0, 0, 0.0099))
    raises(dem.ArgumentError, lambda: world.step(1), "your function (law) keeps its argument c")
    world, glass = heap()
    world.output(kind="csv", path=os.path.join(WORK.name, "values.csv"), interval=1e-4, columns="a", values=lambda world, out: 5)
    raises(dem.ArgumentTypeError, lambda: world.run(1e-3), "your function (values) returned 5")


@test("error messages of dem.h speak of Python: no constants, descs or starts of C")
def _():
    world, glass = heap()
    wall = world.wall_plane(glass, (0, 0, 1), (0, 0, -1))
    for call, *words in (
            (lambda: world.replay(os.path.join(WORK.name, "words.html"), number="heat"), "World(body_reals=...)", "World(groups=...)"),
            (lambda: wall.motion_set(kind="user"), "'user'"),
            (lambda: world.output(kind="call", interval=0.1), "'call'"),
            (lambda: world.material(young=1e7, poisson=0.25, restitution=0.5), "; give density=..."),
            (lambda: world.events_record(), "World(ledger=...) is 0", "when you make the world"),
            (lambda: world.cell_set(rate=(0, 0, 1)), "World("),
            (lambda: world.feed(rate=-1), "")):
        text = str(raises(dem.Error, call, *words))
        assert not re.search(r"DEM_|desc\b|the desc", text.partition(": ")[2]), text
    for c, python in (("sizes, radius: must be > 0; start from DEM_SIZES and set what this kind needs, for example radius", "give the fields that"),
                      ("axis 2 is to be strained, but its boundary is not periodic; set desc.boundary[2] to DEM_BOUNDARY_PERIODIC, or move "
                       "walls instead", "make axis 2 periodic with World(boundary=...), or move"),
                      ("create the world with desc.response = DEM_RESPONSE_IMPULSES", "World(response='impulses')"),
                      ("leave desc.solver at DEM_SOLVER_GAUSS_SEIDEL", "World(solver=...) at 'gauss_seidel'"),
                      ("x is 2; start from DEM_FEED_DESC and set only what differs", "x is 2"),
                      ("x is 2; start from DEM_TRIALS_DESC and set duration", "x is 2; give duration"),
                      ("in an output of kind DEM_OUTPUT_CALL", "kind='call'"), ("group 3 does not exist, desc.groups names 2", "World(groups=...) names 2")):
        text = dem._in_python("dem_call: " + c)
        assert python in text and not re.search(r"DEM_|desc\.", text), text


@test("a friction or rolling law without the stiffness or load that it reads raises, or warns once, by name")
def _():
    def run(name, **fields):
        def law(c, memory, force):
            force.normal = 1e4*c.overlap + 0.3*c.closing_speed
            for field, value in fields.items():
                setattr(force, field, value)
            getattr(dem, name)(c, memory, force)
        world, glass = heap(law=law, law_stiffness=1e4, law_memory=4, law_vectors=1)
        glass.set(rolling_friction=0.1)
        world.sphere(glass, 0.01, (0, 0, 0.0099)).set(velocity=(0.1, 0, 0))
        with warnings.catch_warnings(record=True) as seen:
            warnings.simplefilter("always")
            world.step(5)
        return [str(warning.message) for warning in seen]
    same(dem._LAW_READS["law_spring"], ("kt", "ct", "load"))
    same(dem._LAW_READS["law_roll_epsd"], ("slope", "slope_step", "load"))
    for _ in range(2):                                      # in each world
        raises(dem.ArgumentError, lambda: run("law_spring"), "dem.law_spring: force.kt and load are 0", "dem.law_load")
    raises(dem.ArgumentError, lambda: run("law_mindlin"), "force.kt and kt_step and load")
    for name, fields, lost in (("law_spring", dict(kt=8e3), "load"), ("law_spring", dict(load=1), "kt"), ("law_viscous", dict(ct=1), "load"),
                               ("law_mindlin", dict(kt=8e3, load=1), "kt_step"), ("law_roll_step", {}, "load"), ("law_roll_epsd", dict(
                                   slope=1e4, load=1), "slope_step")):
        seen = run(name, **fields)
        same((len(seen), "dem.%s: force.%s is 0" % (name, lost) in seen[0]), (1, True), name)
    same((run("law_spring", kt=8e3, load=1), run("law_mindlin", kt=8e3, kt_step=8e3, load=1), run("law_viscous", ct=1, load=1)), ([], [], []))


@test("numbers on bodies are set in the order of world.bodies, observables are dicts, sums have x, y and z")
def _():
    world, glass = heap(body_reals="heat age")
    world.spheres_fill(glass, 2e-3, (0, 0, 0, 0.03, 0.03, 0.03), 60, 1)
    world.run(0.2)                                          # dem.h sorts its rows
    wanted = [[float(i), -float(i)] for i in range(60)]
    same(world.bodies_memory.slots[:] == sorted(world.bodies_memory.slots[:]), False)
    world.bodies_reals_set(wanted)
    same((world.bodies.reals.tolist(), list(world.bodies[59].reals)), (wanted, [59.0, -59.0]))
    world.bodies.reals = wanted[::-1]
    same(world.bodies.reals.tolist(), wanted[::-1])
    world.step()
    same((world.totals.centre.z, world.totals.centre[2] > 0), (world.totals.centre[2], True))
    calls = []
    height = dict(name="height", unit="m", function=lambda given: calls.append(1) or given.totals.centre.z)
    for observables in ([height], [dem.Observable(**height)], dem.Observable(**height), height):
        del calls[:]
        same((world.trials_run(duration=1e-3, budget=10, observables=observables).observable_count, bool(calls)), (1, True))
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        dem.World(law=lambda c, memory, force: setattr(force, "normal", c.who.radius_a))
        dem.World(law=lambda c, memory, force: setattr(force, "normal", c.who.radius_a), law_who=1)
        floor = world.wall_plane(glass, (0, 0, 0), (0, 0, 1))
        floor.motion_set(kind="oscillating", velocity=(1, 0, 0), amplitude=0.01)
        floor.motion_set(kind="servo", velocity=(0, 0, 0.01))
        floor.motion_set(kind="rotating", axis=(0, 0, 1), speed=1)
    same([word in str(warning.message) for word, warning in zip(("law_who=1", "without frequency=...", "load=... or table=..."), seen)], [True]*3)
    same(len(seen), 3)


@test("texts that dem.h prints, docstrings and a replay without frames speak of Python")
def _():
    world, glass = heap()
    for _ in range(2):
        world.sphere(glass, 0.01, (0, 0, 0.5))              # two in one place: an error that recommends a call
    out = io.StringIO()
    world.check_print(out)
    world.effects_print(out=out)
    world.report(out)
    same((re.findall(r"\bdem_\w+|\bDEM_\w+|\bdesc\.\w+", out.getvalue()), "world.spheres_fill" in out.getvalue()), ([], True))
    texts = [text for kind in vars(dem).values() if isinstance(kind, type) for text in
             [kind.__doc__ or ""] + [getattr(member, "__doc__", "") or "" for member in vars(kind).values() if callable(member)]]
    same([found for text in texts for found in re.findall(r"\bdesc\.\w+", text)], [])
    same("kn, cn: built-in law" in dem.Contact.__doc__ and "kinetic: Pa, pressure positive: of motion, the sum of m v v" in dem.Stress.__doc__
         and "point, axis: m" in dem.Wall.motion_set.__doc__, True)
    same("\n        - grains that overlap" in dem.World.check.__doc__ and "\n        StoppedError: an output" in dem.World.step.__doc__ and
         "make: make(contact, memory), see dem.ContactFn" in dem.World.bonds_make.__doc__ and 'kind "csv": what a line' in dem.World.output.__doc__, True)
    path = os.path.join(WORK.name, "empty.html")
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        world.replay(path).close()
        with world.replay(path) as replay:
            replay.frame_write()
    same([path in str(warning.message) and "World.replay(interval=...)" in str(warning.message) for warning in seen], [True])


@test("messages name what to write: of vectors, arrays of bodies, ids, groups, options of a world")
def _():
    world, glass = heap()
    ball = world.sphere(glass, 0.01, (0, 0, 0.1))
    for kind, call, *words in (
            (AttributeError, lambda: setattr(world.gravity, "z", -1), "world.gravity = ("),
            (AttributeError, lambda: setattr(world.bodies, "radius", [1]), "World.bodies.radius", "radius_set"),
            (AttributeError, lambda: setattr(world.bodies, "masses", [1]), "World.bodies.masses", "radius_set"),
            (AttributeError, lambda: setattr(world.bodies, "velocity", [1]), "world.bodies.velocities = "),
            (AttributeError, lambda: setattr(ball, "velocity", (0, 0, 1)), "Body.velocity", "body.set(velocity=...)"),
            (AttributeError, lambda: setattr(ball, "radius", 1), "call body.radius_set"),
            (AttributeError, lambda: setattr(glass, "friction", 1), "material.set(friction=...)"),
            (AttributeError, lambda: ball.position, "body.state.position"), (AttributeError, lambda: glass.friction, "material.desc.friction"),
            (AttributeError, lambda: ball.velocty, "did you mean body.state.velocity?"), (AttributeError, lambda: glass.frction, "material.desc.friction"),
            (TypeError, lambda: world.pair_set("glass", glass, friction=1), "World.pair_set: a: 'glass'"),
            (TypeError, lambda: dem.World(gravity=-9.81), "World: gravity: -9.81"), (TypeError, lambda: world.feed(radius="a"), "World.feed: radius: "),
            (TypeError, lambda: world.wall_plane(glass, (0, 0, 0), (0, 0, 1)).motion_set(kind="rotating", speed="a"), "Wall.motion_set: speed: "),
            (TypeError, lambda: world.cell_set(rate="a"), "World.cell_set: rate: "), (TypeError, lambda: world.run(1e-3, "p"), "World.run: progress: 'p'"),
            (ValueError, lambda: dem.World(threads=100), "threads=100"), (ValueError, lambda: dem.World(
                law=lambda *_: None, law_memory=99), "law_memory=99"),
            (ValueError, lambda: world.group("coarse"), "World.group: 'coarse'", "World(groups='coarse')"),
            (ValueError, lambda: world.contacts, "world.step", "world.contacts_each"), (TypeError, lambda: world.bonds_make(0.1), "make is missing"),
            (TypeError, lambda: dem.World(tangent_law=True), "World: tangent_law: True"),
            (AttributeError, lambda: world.walls, "world.wall_plane("), (AttributeError, lambda: world.set_gravity, "read world.gravity"),
            (AttributeError, lambda: world.kinetic, "world.totals.kinetic"), (AttributeError, lambda: world.positions, "read world.bodies.positions"),
            (AttributeError, lambda: world.add_wall, "world.wall_cone or"), (AttributeError, lambda: ball.angular_velocity, "read body.state.spin"),
            (ValueError, lambda: world.ledger, "dem.World(ledger=1)"),
            (TypeError, lambda: world.bodies_remove(group="coarse"), "World.bodies_remove: group: 'coarse'", "write world.group('coarse')"),
            (ValueError, lambda: world.wall_plane(glass, (0, 0, 0), (0, 0, 1)).motion_set(speed=3), "Wall.motion_set: speed: 3", "kind='rotating'"),
            (ValueError, lambda: world.wall_plane(glass, (0, 0, 0), (0, 0, 1)).motion_set(kind="rotating", axis=(0, 0, 1), velocity=(1, 0, 0)),
             "Wall.motion_set: velocity: ", "'rotating'", "'translating' or "), (ValueError, lambda: dem.World(groups="a a"), "groups: 'a'"),
            (ValueError, lambda: dem.World(body_reals=["a", "b", "a"]), "World: body_reals: 'a' is given twice")):
        same(isinstance(raises(kind, call, *words), dem.Error), True, words[0])
    same("first call dem_" in str(raises(dem.Error, lambda: world.contacts)), False)
    same((world.contacts_each(), len(world.contacts)), (0, 0))
    other, steel = heap()
    ball = other.sphere(steel, 0.01, (0, 0, 1))
    other.close()
    raises(dem.Error, lambda: ball.state, "Body.state: this world is closed")
    raises(dem.Error, lambda: ball.remove(), "Body.remove: this world is closed")
    same((hasattr(ball, "shape"), hasattr(world, "__array__")), (False, False))
    same("open" in repr(world.replay(os.path.join(WORK.name, "shown.html"))), True)


@test("arrays in structs show their numbers and take part in sums and products")
def _():
    world, glass = heap()
    world.sphere(glass, 0.01, (1, 2, 3))
    centre = world.totals.centre
    same((repr(centre), centre == (1, 2, 3), centre - (1, 1, 1), 2*centre, centre/2, (1, 1, 1) - centre, centre - centre, dem.Vec3(1, 1, 1) + centre),
         ("[1.0, 2.0, 3.0]", True, [0, 1, 2], [2, 4, 6], [0.5, 1, 1.5], [0, -1, -2], [0, 0, 0], (2, 3, 4)))
    same((abs(dem.World().totals.centre), list(centre), centre[-1], list(centre[:2])), (0, [1, 2, 3], 3.0, [1, 2]))
    raises(TypeError, lambda: centre + (1, 2))
    try:
        import numpy
    except ImportError:
        return
    same(((numpy.ones(3) + centre).tolist(), (centre*numpy.ones(3)).tolist(), numpy.asarray(centre).shape), ([2, 3, 4], [1, 2, 3], (3,)))


@test("from dem import * leaves Python's own names and exports no modules")
def _():
    code = "import sys; sys.path.insert(0, %r)\nfrom dem import *\nprint(compile is __builtins__.compile, MemoryError is __builtins__.MemoryError, 'World' in " \
           "globals(), 'os' in globals(), 'law_hertz' in globals())" % PYTHON
    done = subprocess.run([sys.executable, "-B", "-c", code], capture_output=True, text=True)
    same(done.stdout.split(), ["True", "True", "True", "False", "True"], done.stderr)
    same([name for name in dem.__all__ if inspect.ismodule(getattr(dem, name))], [])


@test("help() speaks of Python: no names, pointers or error codes of C; functions say what they return, fields have their own comment")
def _():
    texts = {}
    for kind in [dem.World, dem.Replay, dem.Slabs, dem] + dem.structs:
        texts[kind.__name__] = kind.__doc__ if kind is not dem else ""
        for name, member in vars(kind).items():
            member = member.fget if isinstance(member, property) else member
            if name[0] != "_" and inspect.isfunction(member) and member.__module__ == "dem" and (kind is dem or not hasattr(dem.Struct, name)):
                texts["%s.%s" % (kind.__name__, name)] = member.__doc__
    same(len(texts) > 250, True, "docstrings")
    for name, text in texts.items():
        if name not in ("dem.build", "dem.load", "dem.compile"):            # which speak of the environment
            found = re.search(r"\b[Nn]ull\b|Free with|on error|[Rr]eturns -1|`out`|capacity|\bdem_\w+|\bDEM_(?!DOMAIN_BODIES|NO_|ROW_GROUP|LAW)\w+|>>\w|\w->\w|Returns: None", text or "")
            same(found and text[max(0, found.start() - 60):found.end() + 20], None, name)
    for kind, name, words in ((dem.Body, "state", "Returns: BodyState"), (dem.World, "contacts", "Returns: Structs of ContactInfo"),
                              (dem.World, "sphere", "Returns: Body"), (dem.World, "check", "Returns: a list of Finding"),
                              (dem.World, "mesh_read", "Returns: Mesh, MeshHealth")):
        member = inspect.getattr_static(kind, name)
        same(words in inspect.getdoc(member), True, name)
    for kind, lines in ((dem.BodyState, ("position: m\n", "velocity: m/s\n", "torque: N m: of the last step")), (dem.Totals, ("momentum: momentum, kg m/s",)),
                        (dem.Motion, ("frequency: Hz: of oscillating walls",)), (dem.Ledger, ("walls: supplied: work of moving walls",)),
                        (dem.ContactForce, ("load: N, >= 0: L of Coulomb", "elastic: N, the part of"))):
        for line in lines:
            same(line in kind.__doc__, True, "%s in the docstring of %s" % (line, kind.__name__))


# ---- mistakes that are refused by name ----

def refused(kind, calls):
    """Each call raises this kind of exception, which is a dem.Error, with these words."""
    for call, *words in calls:
        same(isinstance(raises(kind, call, *words), dem.Error), True, words[0])


@test("numbers on bodies that a function sees are not read or written beyond their end")
def _():
    two = dict(body_reals="heat age")

    def run(use, **more):
        def law(c, memory, force):
            force.normal = 1e4*c.overlap
            use(c.who)
        world, glass = heap(law=law, law_who=1, law_stiffness=1e4, **more)
        world.spheres(glass, [(0, 0, 0.0099), (0.0199, 0, 0.0099)], radius=0.01)
        world.step(2)

    def read(who):
        return getattr(who, name)[index]

    def write(who):
        getattr(who, name)[index] = 1.0
    for name in ("reals_a", "reals_b", "rate_a", "rate_b"):
        for index in (2, -3, 10**6):
            words = "ContactWho.%s: %d is given" % (name, index), "numbers 0 to 1; World(body_reals=...) names 2"
            refused(IndexError, [(lambda: run(read, **two), *words)])
            if "rate" in name:
                refused(IndexError, [(lambda: run(write, **two), *words)])
        index = 0
        refused(IndexError, [(lambda: run(read), "ContactWho.%s: 0 is given" % name, "no numbers", "names 0")])
    name = "reals_a"
    refused(dem.FieldError, [(lambda: run(write, **two), "a function may only read it")])
    seen = []
    run(lambda who: seen.append((len(who.reals_a), who.reals_b[-1], list(who.rate_a), bool(who.rate_b),
                                 copy.copy(who).reals_a[:])), **two)
    same(seen[0], (2, 0.0, [0.0, 0.0], True, []))           # a copy has no pointers
    raises(ValueError, lambda: run(lambda who: seen.append(who.reals_a), **two), "keeps its argument c")
    for more in (dict(body_force=lambda body, *_: body.reals[2] and None), dict(growth=lambda body, *_: body.reals[2])):
        world, glass = heap(**two, **more)
        ball = world.sphere(glass, 0.01, (0, 0, 0.1))
        ball.reals_set([3, 4])
        refused(IndexError, [(lambda: world.step(1), "BodyState.reals: 2 is given", "names 2")])
    same((list(ball.state.reals), ball.state.to_dict()["reals"]), ([3, 4], [3, 4]))
    raises(dem.FieldError, lambda: ball.state.reals.__setitem__(0, 1), "body.reals_set(...)")
    world, glass = heap(groups="a b")
    same(list(world.sphere(glass, 0.01, (0, 0, 1)).state.reals), [])
    refused(IndexError, [(lambda: world.bodies_memory.groups[1], "(1,)")])
    who = dem.Contact(who=dem.ContactWho(reals_a=[1, 2], rate_a=[0, 0])).who    # made by hand to test a law
    same((list(who.reals_a), len(who.reals_b)), ([1, 2], 0))


@test("a law of rows in Python gives the bits of the law, and is not used beyond its columns")
def _():
    def law(c, memory, force):
        force.normal = 1e4*c.overlap

    def rows(r):
        for q in range(r.count):
            r.normal_force[q] = 1e4*r.overlap[q]
            r.slides[q] = r.tangent[0][q] = r.tangent[1][q] = r.tangent[2][q] = 0
            r.moment[0][q] = r.moment[1][q] = r.moment[2][q] = 0
        same((len(r.normal), r.normal[2].shape, len(r.memory), r.energy[0]), (3, (r.count,), 0, None))
        beyond(r)

    def run(**more):
        world, glass = heap(law=law, law_stiffness=1e4, **more)
        world.spheres(glass, [(0.0199*i, 0, 0.0099) for i in range(20)], radius=0.01)
        world.step(5)
        return world.hash

    def beyond(r):
        pass
    same(run(law_rows=rows), run())
    for use in (lambda r: r.overlap[r.count], lambda r: r.normal_force.__setitem__(10**6, 1.0),
                lambda r: r.tangent[2].__setitem__(-10**6, 1.0)):
        beyond = use
        refused(IndexError, [(lambda: run(law_rows=rows), "array[...]: ")])


@test("an argument that has no use beside the others is refused, with what it belongs to")
def _():
    world, glass = heap()
    rigid = dem.World(response="impulses", dt=1e-3, orientations=1)
    steel = rigid.material(density=2500)
    a, b = rigid.sphere(steel, 0.1, (1, 0, 0)), rigid.sphere(steel, 0.1, (3, 0, 0))
    wall = rigid.wall_plane(steel, (0, 0, -9), (0, 0, 1))
    ball, box, springs = world.sphere(glass, 0.01, (0, 0, 1)), (0, 0, 0, 1, 1, 1), "response='springs'"

    def law(c, memory, force):
        pass

    def impulses(**more):
        return dem.World(response="impulses", dt=1e-3, **more)

    def output(kind, **more):
        return world.output(kind=kind, path=os.path.join(WORK.name, "unused"), interval=1, **more)

    def joint(kind, **more):
        return rigid.joint(kind=kind, a=a, **more)

    def sizes(**more):
        return world.sizes_draw(dem.Sizes(**more), 3, 0)

    def cluster(**more):
        return world.shape_cluster(positions=[(0, 0, 0), (1e-3, 0, 0)], radius=1e-3, **more)

    def servo(**more):
        return world.wall_plane(glass, (0, 0, 5), (0, 0, -1)).motion_set(kind="servo", velocity=(0, 0, -1), **more)
    refused(ValueError, (
        (lambda: dem.World(sweeps=5), "World: sweeps: 5", "with " + springs, "belongs to response='impulses'"),
        (lambda: dem.World(cone="convex"), "World: cone: 'convex'"),
        (lambda: dem.World(solver="apgd"), "World: solver: 'apgd'"),
        (lambda: dem.World(tolerance=1), "World: tolerance"),
        (lambda: dem.World(cold_start=1), "World: cold_start"),
        (lambda: dem.World(unsolved_stops=1), "World: unsolved_stops"),
        (lambda: impulses(normal_law="linear"), "World: normal_law: 'linear'", "belongs to " + springs),
        (lambda: impulses(tension="clipped"), "World: tension"),
        (lambda: impulses(slider="spring"), "World: slider"),
        (lambda: dem.World(tangent_law="spring", law=law), "World: tangent_law", "beside law=..."),
        (lambda: dem.World(law_memory=3), "World: law_memory: 3", "without law=...", "leave out law_memory"),
        (lambda: dem.World(law_stiffness=1e4), "World: law_stiffness"),
        (lambda: dem.World(growth_interval=1), "World: growth_interval", "give growth=..."),
        (lambda: dem.World(thickness=0.01), "World: thickness", "give planar=..."),
        (lambda: output("vtp", columns="a"), "World.output: columns: 'a'", "kind='vtp'", "kind='csv'"),
        (lambda: output("csv", function=law), "World.output: function", "kind='call'"),
        (lambda: output("csv", z0=1), "World.output: z0", "kind='walls'"),
        (lambda: output("vtp", mixing=dict(box=box, cells=(1, 1, 1))), "World.output: mixing"),
        (lambda: joint("point", axis=(0, 0, 1)), "World.joint: axis", "kind='revolute'"),
        (lambda: joint("point", motor="speed"), "World.joint: motor: 'speed'", "kind='revolute'"),
        (lambda: joint("revolute", axis=(0, 0, 1), speed=1), "World.joint: speed", "motor='none'", "motor='speed'"),
        (lambda: joint("revolute", axis=(0, 0, 1), torque=1), "World.joint: torque", "motor='speed' or 'torque'"),
        (lambda: joint("point", b=b, wall=wall), "World.joint: wall", "beside b=..."),
        (lambda: sizes(min=1, max=2, median=1), "World.sizes_draw: sizes: median", "kind='uniform'",
         "kind='lognormal' or 'normal'"),
        (lambda: sizes(kind="normal", median=1, deviation=1, spread=1), "sizes: spread", "kind='lognormal'"),
        (lambda: sizes(kind="weibull", min=1, scale=1, modulus=2, radius=[1, 2]), "sizes: radius"),
        (lambda: world.feed(material=glass, radius=[1e-3], amount=[1], limited=1, box=box, sizes=[
            dem.Sizes(kind="uniform", min=1e-3, max=2e-3, scale=1)]), "World.feed: sizes: scale"),
        (lambda: cluster(volume=1e-9), "World.shape_cluster: volume", "mass='union'", "mass='given'"),
        (lambda: cluster(mass="sum", rays=64), "World.shape_cluster: rays", "mass='union'"),
        (lambda: ball.rail_set(velocity=(0, 0, 1)), "Body.rail_set: velocity", "give axes=..."),
        (lambda: world.mixing(box=box, cells=(1, 1, 1), radius_max=1, centre=(0, 0, 1)), "World.mixing: centre"),
        (lambda: heap(ledger=1)[0].events_record(begins=1), "World.events_record: begins", "function=..."),
        (lambda: servo(load=1, table=[(0, (0, 0, 0), None, 1), (1, (0, 0, 0), None, 2)]), "load", "beside table=...")))
    same(joint("revolute", axis=(0, 0, 1), motor="torque", torque=1).state.turned, 0.0)
    for again in (dem.World(), dem.World(planar=1, thickness=0.01), rigid):     # a desc makes the same world again
        same(dem.World(**again.desc.to_dict()).desc.thickness, again.desc.thickness)
    impulses(normal_law="hertz", law=None)                  # the defaults
    same((ball.rail_set(axes=0), sizes(kind="exponential", min=1, scale=2)[0] > 1), (None, True))


@test("a feed without a box, and a call without another required field, are refused by name")
def _():
    world, glass = heap()
    box, feed = (0, 0, 0, 1, 1, 1), dict(radius=[1e-3], amount=[1], rate=10)
    refused(ValueError, (
        (lambda: world.feed(material=glass, **feed), "World.feed: box was not given", "centres lie inside",
         "give box=(x0, y0, z0, x1, y1, z1)"),
        (lambda: world.feed(box=box, **feed), "World.feed: material was not given"),
        (lambda: world.feed(material=glass, box=box, rate=10), "World.feed: radius was not given"),
        (lambda: world.outlet(), "World.outlet: box"),
        (lambda: world.field(cells=(1, 1, 1)), "World.field: box"),
        (lambda: world.field(box=box), "World.field: cells"),
        (lambda: world.mixing(cells=(1, 1, 1)), "World.mixing: box"),
        (lambda: world.spheres_fill(glass, 1e-3, {}, 3, 1), "World.spheres_fill: region: box"),
        (lambda: world.bodies_remove(region={"cylinder": "z"}), "World.bodies_remove: region: box"),
        (lambda: world.material(young=1e7), "World.material: density", "kg/m3"),
        (lambda: world.joint(a=None), "World.joint: kind"),
        (lambda: world.wall_sieve(glass, kind="wires", bar=1), "World.wall_sieve: aperture"),
        (lambda: world.shape_cluster(), "World.shape_cluster: positions"),
        (lambda: world.trials_run(), "World.trials_run: duration"),
        (lambda: world.output(function=lambda *_: 0), "World.output: interval")))
    same(world.feed(material=glass, box=(0, 0, 1, 0, 0, 1), **feed).id, 1)      # a point is a box


@test("a cell with a stress but no rate_most, and a servo with a load below 0, are refused")
def _():
    cell = dem.World(domain=(0, 0, 0, 1, 1, 1), boundary=["periodic"]*3)
    for more in ({}, dict(rate=(0, 0, -1))):
        refused(dem.ArgumentError, [(lambda: cell.cell_set(stress=(1, 1, 1), **more), "World.cell_set: stress",
                                     "without rate_most=... it has no use; give rate_most=...")])
    cell.cell_set(rate=(0, 0, -1), stress=(1, 1, 1), rate_most=(1, 1, 0))
    cell.cell_set(rate_most=(1, 1, 1))                      # towards the stress 0
    world, glass = heap()
    lid = world.wall_plane(glass, (0, 0, 5), (0, 0, -1))

    def press(**more):
        return lid.motion_set(kind="servo", velocity=(0, 0, -1), **more)
    refused(dem.ArgumentError, [(lambda: press(load=-1), "Wall.motion_set: load: -1.0", "must be >= 0", "reverse it")])
    for table in ([(0, (0, 0, 0), None, 1), (1, (0, 0, 0), None, -1)], [dict(time=0, load=-1), dict(time=1, load=1)],
                  [dem.MotionRow(time=0), dem.MotionRow(time=1, load=-1)]):
        refused(dem.ArgumentError, [(lambda: press(table=table), "Wall.motion_set: table: load", "reverse it")])
    same((press(load=1), lid.servo.target >= 0), (None, True))


@test("Ctrl-C ends World.trials_run within a second: alone, in threads, in a pool of processes")
def _():
    code = """
import concurrent.futures, multiprocessing, os, signal, sys, threading, time
sys.path.insert(0, %r)
import dem

def sweep(seed):
    with dem.World(gravity=(0, 0, -9.81), threads=1) as world:
        glass = world.material(density=2500, young=1e7, poisson=0.25, restitution=0.5, friction=0.5)
        world.wall_plane(glass, (0, 0, 0), (0, 0, 1))
        world.spheres_fill(glass, 2e-3, (-.02, -.02, 0, .02, .02, .2), 300, seed)
        return world.trials_run(duration=50, budget=1e3).advice

def interrupt():
    print(time.time(), flush=True)
    os.kill(0, signal.SIGINT)           # all processes, as a terminal does

if __name__ == "__main__":
    kind = sys.argv[1]
    dem.load()
    threading.Timer(3 if kind == "processes" else 1, interrupt).start()
    if kind == "alone":
        sweep(1)
    elif kind == "threads":
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            list(pool.map(sweep, range(4)))
    else:
        with multiprocessing.get_context("spawn").Pool(2) as pool:
            pool.map(sweep, range(4))
""" % PYTHON
    path = os.path.join(WORK.name, "sweep.py")
    with open(path, "w") as file:
        file.write(code)
    for kind in ("alone", "threads", "processes"):
        child = subprocess.Popen([sys.executable, "-B", path, kind], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                 text=True, start_new_session=True)
        try:
            out, error = child.communicate(timeout=30)
            took = time.time() - float(out)
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(child.pid, signal.SIGKILL)        # what is left of its processes
        more = re.findall(r"^\S*(?:Error|Warning|Exception)\b.*|.*dem\.h:.*", error, re.M)
        same((took < 2, error.rstrip().split("\n")[-1], more), (True, "KeyboardInterrupt", []),
             "%s: %.1f s: %s" % (kind, took, error[-500:]))
    import _thread
    world, glass = heap()
    world.sphere(glass, 0.01, (0, 0, 1))
    world.step(10)
    before = world.hash
    threading.Timer(0.3, _thread.interrupt_main).start()
    raises(KeyboardInterrupt, lambda: world.trials_run(duration=1e4, budget=1e4))
    same(world.hash, before)
    world.run(0.01)                                         # the state is intact


@test("a message about an array of a call names the array and the index, not a body")
def _():
    nan, (world, glass) = float("nan"), heap(body_reals="heat")
    shape = world.shape_ellipsoid((3e-3, 2e-3, 2e-3))
    world.spheres(glass, [(0.1*i, 0, 1) for i in range(5)], radius=0.01)
    world.bodies[1].remove()                                # slots are not rows
    two, bodies, up = [(0, 0, 3), (0, 0, 4)], world.bodies, (0, 0, 1)

    def add(positions=two, velocities=None, **more):
        return world.spheres(glass, positions, velocities, **more)

    def shapes(**more):
        return world.bodies_add(glass, shape, two, **more)
    before = bodies.positions, bodies.velocities, bodies.spins, bodies.reals
    for call, text in (
            (lambda: add([up, (0, nan, 1)], radius=0.01), "positions[1] is (0, nan, 1) m, must be finite"),
            (lambda: add(velocities=[up, (0, 0, 1e20)], radius=0.01), "velocities[1] is (0, 0, 1e+20) m/s"),
            (lambda: add(radii=[1, -1]), "radii[1] is -1 m"), (lambda: add(radius=-1), "radius is -1 m"),
            (lambda: world.sphere(glass, 0.01, (0, 0, nan)), "position is (0, 0, nan) m"),
            (lambda: shapes(orientations=[(1, 0, 0, 0), (0, 0, 0, 0)]), "orientations[1] is (0, 0, 0, 0)"),
            (lambda: shapes(spins=[(0, nan, 0), up]), "spins[0] is (0, nan, 0) rad/s"),
            (lambda: shapes(scales=[1, -1]), "scales[1] is -1"),
            (lambda: world.grains(glass, dem.Grains(positions=two, radii=[1, -1])), "radii[1] is -1 m"),
            (lambda: setattr(bodies, "positions", [up]*3 + [(0, 0, nan)]), "World.bodies.positions[3] is (0, 0, nan)"),
            (lambda: setattr(bodies, "velocities", [(0, 1e20, 1)]*4), "World.bodies.velocities[0] is (0, 1e+20, 1)"),
            (lambda: setattr(bodies, "spins", [up, up, (nan, 0, 0), up]), "World.bodies.spins[2] is (nan, 0, 0)"),
            (lambda: setattr(bodies, "reals", [1, 2, nan, 4]), "World.bodies.reals[2] is (nan)"),
            (lambda: world.bodies_reals_set([1, 2, 3, nan]), "World.bodies.reals[3] is (nan)"),
            (lambda: add([up, (0, 0)], radius=0.01), "row 1 has the shape (2,)")):
        message = str(raises(ValueError, call, text))
        same("of body" in message or "of sphere" in message, False, message)
    same((bodies.positions, bodies.velocities, bodies.spins, bodies.reals) == before, True, "nothing was changed")


@test("contacts of a wall after bodies were removed: 0 if none is left, else refused by name")
def _():
    for more in ({}, dict(response="impulses", dt=1e-3)):
        world, glass = heap(**more)
        wall = world.wall_plane(glass, (0, 0, 0.001), (0, 0, 1))
        same(wall.loads.contacts, 0)
        first, second = (world.sphere(glass, 0.01, (x, 0, 0.0109)) for x in (0, 0.1))
        world.step(3)
        same(wall.loads.contacts, 2)
        first.remove()
        loads = wall.loads
        refused(dem.ArgumentError, [(lambda: loads.contacts, "WallLoads.contacts: ", "not known", "world.step()")])
        same((loads.to_dict()["contacts"], "contacts=None" in repr(loads)), (None, True))
        same(loads.force.z < 0, True, "the force of the last step")
        world.contacts_each()
        same(wall.loads.contacts, 1)
        second.remove()
        same(wall.loads.contacts, 0)
        world.step(1)
        same((wall.loads.contacts, wall.loads.touched), (0, 1))


@test("each method that is called on its class raises a dem.Error that names what it needs")
def _():
    refused(TypeError, (
        (lambda: dem.World.step(1), "World.step: 1 (int) is given in the place of the World that this call needs",
         "write world.step(...)"),
        (lambda: dem.World.close(), "World.close: nothing is given in the place of the World"),
        (lambda: dem.Body.set(velocity=(0, 0, 1)), "Body.set: nothing is given in the place of the Body"),
        (lambda: dem.Wall.motion_set(dem.World()), "Wall.motion_set: ", "(World) is given in the place of the Wall"),
        (lambda: dem.Rows.to_dict(), "write world.bodies.to_dict(...)")))
    calls = 0
    for kind in [dem.World, dem.Replay, dem.Slabs, dem.Rows, dem.Array, dem.Structs] + dem.structs:
        for name in dir(kind):
            if name[0] != "_" and inspect.isfunction(inspect.getattr_static(kind, name)):
                for values in ((), (1,), ("x", 2), (dem, 1)):
                    refused(TypeError, [(lambda: getattr(kind, name)(*values), " that this call needs; write ")])
                    calls += 1
    same(calls > 900, True, "calls: %d" % calls)
    world, glass = heap()
    same((dem.World.step(world, 1), world.steps, dem.Vec3.dot(dem.Vec3(1, 2, 3), (1, 1, 1))), (None, 1, 6.0))


# ---- all calls ----

@test("no call with wrong values in any argument ends the process, and each exception is a dem.Error")
def _():
    import walk
    total, refused, accepted, wrong = walk.main(int(os.environ.get("JOBS") or os.cpu_count() or 1))
    print("# %d calls: %d refused, %d accepted" % (total, refused, accepted))
    same((wrong[:5], refused + accepted, total > 50000), ([], total, True))


@test("messages of wrong calls name the call, the argument, what is given and what is wanted")
def _():
    world, glass = heap()
    ball = world.sphere(glass, 0.01, (0, 0, 0.1))
    for call, text in ((lambda: world.sphere(glass, (0, 0, 1), 0.01), "World.sphere: radius: (0, 0, 1) (tuple) is given, a number is wanted"),
                       (lambda: world.run("1"), "World.run: seconds: '1' (str) is given, a number is wanted"),
                       (lambda: world.step(2**40), "World.step: steps: 1099511627776 is given, must be from -2147483648 to 2147483647"),
                       (lambda: world.vtp_write(5), "World.vtp_write: path: 5 (int) is given, a text is wanted"),
                       (lambda: world.vtp_write("a\0b"), "World.vtp_write: path: b'a\\x00b' (bytes) is given, a text without the character 0 is wanted"),
                       (lambda: ball.set(velocity=3), "Body.set: velocity: 3 (int) is given, a Vec3, or 3 numbers (x, y, z) is wanted"),
                       (lambda: world.run(1, progress=True), "World.run: progress: True (bool) is given, a function is wanted"),
                       (lambda: world.output_every("vtu", "a.vtu", 1), "World.output_every: kind: OutputKind has no 'vtu'; it has "),
                       (lambda: world.report(5), "report: out: 5 (int) is given, a file of Python is wanted"),
                       (lambda: world.slabs(axis="x"), "World.slabs: axis: 'x' (str) is given, a whole number is wanted"),
                       (lambda: dem.World(body_reals=5), "World: body_reals: 5 (int) is given, a text is wanted"),
                       (lambda: copy.copy(world), "a World owns memory of dem.h and cannot be copied or pickled")):
        error = raises(dem.Error, call)
        same(str(error)[:len(text)], text)
        same(isinstance(error, (ValueError, TypeError, OverflowError)), True)


@test("structs are pickled, copied and compared; a process pool returns them; worlds refuse by name")
def _():
    import pickle
    world, glass = heap(ledger=1, groups="a")
    ball = world.sphere(glass, 0.01, (0, 0, 0.1))
    world.run(0.01)
    mesh = dem.Mesh(vertices=[(0, 0, 0), (1, 0, 0), (0, 1, 0)], triangles=[(0, 1, 2)])
    grains = world.grains_parse("g.csv", "x y z r\n1 2 3 0.1\n4 5 6 0.2\n")
    for struct in (dem.Vec3(1, 2, 3), world.totals, world.ledger, ball.state, world.counters, world.desc, glass.desc, mesh, grains, ball, glass,
                   dem.Region(box=(0, 0, 0, 1, 1, 1), cylinder="z"), dem.Selection(bodies=[ball], region=dem.Region(box=(0, 0, 0, 1, 1, 1))),
                   dem.Sizes(kind="sieve_curve", radius=[1, 2], passing=[0, 1]), world.body_counts, dem.Motion(kind="rotating"),
                   dem.Motion(kind="table", table=[dem.MotionRow(0, (0, 0, 0)), dem.MotionRow(1, (0, 0, 1))]), dem.WorldDesc(groups="a b")):
        for made in (pickle.loads(pickle.dumps(struct)), copy.copy(struct), copy.deepcopy(struct)):
            same(type(made), type(struct))
            same(made.to_dict() if not isinstance(made, dem.Id) else made, struct.to_dict() if not isinstance(struct, dem.Id) else struct,
                 type(struct).__name__)
    same(pickle.loads(pickle.dumps(mesh)).vertices.tolist(), [[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    same((world.totals == world.totals, world.totals == dem.Totals(), dem.Vec3(1, 2, 3) == (1, 2, 3), dem.Vec3(1, 2, 3) != [1, 2, 4],
          dem.Motion(kind="rotating") == dem.Motion(kind="rotating"), dem.Vec3() == "abc"), (True, False, True, True, True, False))
    for thing in (world, world.slabs(axis=0, count=1), world.replay(os.path.join(WORK.name, "p.html"))):
        for function in (pickle.dumps, copy.copy, copy.deepcopy):
            raises(TypeError, lambda: function(thing), type(thing).__name__, "copied or pickled", "checkpoint")
    code = ("import sys, multiprocessing, concurrent.futures; sys.path.insert(0, %r); import dem\n"
            "def job(height):\n"
            "    with dem.World(gravity=(0, 0, -9.81), threads=1) as world:\n"
            "        ball = world.sphere(world.material(density=2500, young=1e7, poisson=0.25, restitution=0.5), 0.01, (0, 0, height))\n"
            "        world.run(0.01)\n"
            "        return ball.state, world.totals\n"
            "if __name__ == '__main__':\n"
            "    with concurrent.futures.ProcessPoolExecutor(2, mp_context=multiprocessing.get_context('spawn')) as pool:\n"
            "        (one, total), (two, _) = pool.map(job, (1, 2))\n"
            "    print(round((two.position - one.position).z, 9), total.mass == one.mass)\n" % PYTHON)
    path = os.path.join(WORK.name, "pool.py")
    with open(path, "w") as file:
        file.write(code)
    done = subprocess.run([sys.executable, "-B", path], capture_output=True, text=True)
    same(done.stdout.split(), ["1.0", "True"], done.stderr[-500:])


@test("Vec3 and Quat are numbers: sums, products, lengths, comparison with tuples")
def _():
    v, w = dem.Vec3(3, 4, 0), dem.Vec3(1, 2, 3)
    same((v + w, v - w, 2*v, v*w, v/2, -v, abs(v), v.dot(w), v.cross(w)),
         ((4, 6, 3), (2, 2, -3), (6, 8, 0), (3, 8, 0), (1.5, 2, 0), (-3, -4, 0), 5.0, 11.0, (12, -9, 2)))
    same((v + (1, 1, 1), (1, 1, 1) - v, sum([v, w], dem.Vec3()), list(v), v[0], v[-1], v["y"], tuple(v[:2])),
         ((4, 5, 1), (-2, -3, 1), (4, 6, 3), [3, 4, 0], 3.0, 0.0, 4.0, (3.0, 4.0)))
    v += w
    same((v, type(v), dem.Quat(1, 0, 0, 0)*2), ((4, 6, 3), dem.Vec3, (2, 0, 0, 0)))
    raises(TypeError, lambda: v + (1, 2))
    raises(TypeError, lambda: v + "abc")


@test("worlds, ids and arrays show what they are")
def _():
    world, glass = heap()
    ball = world.sphere(glass, 0.01, (0, 0, 0.1))
    world.step(2)
    same((repr(world), repr(glass), repr(ball)), ("<World at %.6g s: 1 bodies, step 2>" % world.time, "Material(id=1)", "Body(slot=1, generation=1)"))
    same("1 bodies" in repr(world.bodies) and repr(world.contacts) == "<0 ContactInfo>", True)
    columns = world.contacts.to_dict()
    same((columns["overlap"], "point_x" in columns), ([], True))
    same(set(world.totals.to_dict()), set(dem.Totals.kinds))
    world.close()
    same((repr(world), bool(world)), ("<World, closed>", True))


# ---- programs ----

@test("a belt in Python: drag is mass flow times speed within 2 %, power is drag times speed")
def _():
    result = subprocess.run([sys.executable, "-B", os.path.join(PYTHON, "belt.py")], capture_output=True, text=True, cwd=WORK.name)
    rows = re.findall(r"^([\d.]+) m/s: drag ([\d.]+) N, mass flow times speed ([\d.]+) N, power ([\d.]+) W$", result.stdout, re.M)
    same(len(rows), 3, result.stderr[-800:])
    for speed, drag, expected, power in ([float(number) for number in row] for row in rows):
        near(drag, expected, 0.02)                          # 300 grains, fed at random places: those on the belt differ by a few
        near(power, drag*speed, 0.005)                      # four digits are printed


# ---- the pages ----

DEBIAN = {"numpy": "python3-numpy", "pandas": "python3-pandas", "matplotlib": "python3-matplotlib", "tqdm": "python3-tqdm"}


def missing(code, what):
    """Whether a package that the code imports is missing. If so, it prints which."""
    names = [name for name in re.findall(r"^(?:import|from) (\w+)", code, re.M) if name in DEBIAN and not importlib.util.find_spec(name)]
    for name in names:
        print("SKIP: %s not found (Debian package %s): %s is not run" % (name, DEBIAN[name], what))
    return bool(names)


def page(name):
    """The text of a page."""
    with open(os.path.join(ROOT, "docs", name), encoding="utf-8") as file:
        return file.read()


def blocks(text):
    """The Python blocks of a page: code, what the page shows behind it (or ""), and "varies" or ""."""
    return [(code, shown or line and line + "\n", varies.strip()) for code, varies, shown, line in re.findall(
        r"```python\n(.*?)```(?:\n```text( varies)?\n(.*?)```|\nIt prints `(.*?)`)?", text, re.S)]


def environment(**more):
    """The environment of a process that imports dem."""
    return dict(os.environ, PYTHONPATH=os.pathsep.join(filter(None, [PYTHON, os.environ.get("PYTHONPATH")])), PYTHONIOENCODING="utf-8",
                PYTHONDONTWRITEBYTECODE="1", DEM_BUILD=os.path.abspath(os.environ["DEM_BUILD"]), **more)


def program(what, *code, folder=WORK.name, **more):
    """Runs Python code in a process of its own, from a file, because the processes of a pool import it. Returns what it
    prints."""
    path = os.path.join(folder, "recipe.py")
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n\n".join(code))
    result = subprocess.run([sys.executable, "-B", path], capture_output=True, text=True, cwd=folder, encoding="utf-8",
                            env=environment(MPLBACKEND="Agg", **more))
    if result.returncode:
        raise AssertionError("%s: %s" % (what, result.stderr[-1500:]))
    return result.stdout


def alike(shown, printed, varies, what):
    """Compares what a recipe prints with what its page shows, by the rules of the recipes in C."""
    expected, log = os.path.join(WORK.name, "shown.expected"), os.path.join(WORK.name, "shown.log")
    for path, text in ((expected, (varies or "same") + "\n" + shown), (log, printed)):
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
    result = subprocess.run(["awk", "-f", os.path.join(ROOT, "tests", "printed.awk"), expected, log], capture_output=True, text=True)
    if result.returncode:
        raise AssertionError("%s: the page %s" % (what, (result.stdout or result.stderr)[-800:]))


@test("dem.h is found beside dem.py, also through a symlink and by PYTHONPATH; without it the message names the places")
def _():
    show = "import dem; print(dem._header())"
    header = os.path.join(ROOT, "dem.h")
    with tempfile.TemporaryDirectory() as folder:
        env = environment()
        env.pop("DEM_H", None)
        run = lambda: subprocess.run([sys.executable, "-B", "-c", show], capture_output=True, text=True, cwd=folder, env=env)
        assert os.path.samefile(run().stdout.strip(), header)                          # by PYTHONPATH, which environment() sets
        env["PYTHONPATH"] = folder
        os.symlink(os.path.join(PYTHON, "dem.py"), os.path.join(folder, "dem.py"))
        assert os.path.samefile(run().stdout.strip(), header)
        os.remove(os.path.join(folder, "dem.py"))
        shutil.copy(os.path.join(PYTHON, "dem.py"), folder)
        lost = run().stderr
        assert os.path.isfile("/usr/local/include/dem.h") or "dem.h was not found" in lost and folder in lost, lost


@test("the Python programs of docs/python.md run and print what the page shows")
def _():
    parts = ["import io, sys", "from contextlib import redirect_stdout"]
    found = blocks(page("python.md"))
    for code, expected, _ in found:
        parts.append("with redirect_stdout(io.StringIO()) as out:\n    exec(compile(%r, 'python.md', 'exec'))\nexpected = %r\n"
                     "if expected and out.getvalue() != expected: sys.exit('the page shows %%r, the program prints %%r' %% (expected, out.getvalue()))"
                     % (code, expected))
    same(len(found) > 5, True, "blocks")
    program("python.md", *parts)


@test("the cell of docs/platforms.md runs and shows its replay")
def _():
    cell = blocks(page("platforms.md"))[0][0]
    same(cell.endswith("\nreplay\n"), True, "the last line")
    printed = program("platforms.md", cell, "print(replay._repr_html_()[:7], len(replay._repr_html_()) > 10000)")
    same(printed.split("\n")[-2], "<iframe True", "what the cell shows")


def recipe(heading, text):
    @test("python_how_to.md: " + heading)
    def _():
        (code, shown, varies), = blocks(text)
        same((len(code.split("\n")) <= 27, bool(shown)), (True, True), "a recipe has at most 26 lines and shows what it prints")
        if not missing(code, "the recipe \"%s\"" % heading):
            with tempfile.TemporaryDirectory() as folder:
                alike(shown, program(heading, code, folder=folder), varies, heading)


for recipe_of in re.findall(r"^### (.*?)\n(.*?)(?=^##|\Z)", page("python_how_to.md"), re.S | re.M):
    recipe(*recipe_of)


@test("the Python lines beside the C lines of docs/how_to*.md run and print what the pages show")
def _():
    first, = [code for code, _, _ in blocks(page("how_to.md")) if "\ndef scene(" in code]
    frame = first[:first.index("# the recipe")]
    mark = "---- recipe %d ----"
    os.makedirs(os.path.join(WORK.name, "examples", "data"), exist_ok=True)
    with open(os.path.join(ROOT, "examples", "data", "hopper.stl"), "rb") as file, \
         open(os.path.join(WORK.name, "examples", "data", "hopper.stl"), "wb") as copied:
        copied.write(file.read())
    for name in ("how_to.md", "how_to_shapes.md", "how_to_more.md"):
        found = blocks(page(name))
        same(len(found) > 1, True, "blocks of " + name)
        whole = [frame] + ["print(%r)\n%s" % (mark % i, code if code != first else code[len(frame):]) for i, (code, _, _) in enumerate(found)]
        printed = program(name, *whole)
        for i, (code, shown, varies) in enumerate(found):
            got = printed.split(mark % i + "\n")[1].split("---- recipe")[0]
            alike(shown, got, varies, "%s, block %d" % (name, i + 1))


# ---- the notebooks ----

# what makes the runs short, words of what a notebook prints, and the kind of its pictures
NOTEBOOKS = {"drum.ipynb": ({"DRUM_SECONDS": "0.04"}, ("torque = ", "angle of repose", "rolling friction = "), "text/html"),
             "triaxial.ipynb": ({"TRIAXIAL_GRAINS": "150", "TRIAXIAL_YOUNG": "1e7"}, ("dense: peak angle = ", "loose: peak angle = "), "image/png")}


def notebook(name):
    """Checks the format of a notebook and executes it, with nbconvert if that is installed, else its cells as a program.
    Returns what it prints."""
    short, words, picture = NOTEBOOKS[name]
    path = os.path.join(PYTHON, name)
    with open(path, encoding="utf-8") as file:
        book = json.load(file)
    same((book["nbformat"], book["nbformat_minor"] >= 5), (4, True))
    same(book["metadata"]["kernelspec"]["language"], "python")
    ids = [cell["id"] for cell in book["cells"]]
    same(len(set(ids)), len(ids), "ids")
    code = []
    for cell in book["cells"]:
        same(set(cell) - {"id", "cell_type", "metadata", "source"}, {"outputs", "execution_count"} if cell["cell_type"] == "code" else set(), "keys")
        same(bool(re.match(r"^[a-zA-Z0-9_-]{1,64}$", cell["id"])), True, cell["id"])
        same(all(isinstance(line, str) and (line.endswith("\n") or line is cell["source"][-1]) for line in cell["source"]), True, "source")
        if cell["cell_type"] == "code":
            same((cell["outputs"], cell["execution_count"]), ([], None), "a notebook is kept without outputs")
            code.append("".join(cell["source"]))
    if missing("\n".join(code), name):
        return None
    more = {} if LONG else short
    if all(importlib.util.find_spec(module) for module in ("nbconvert", "ipykernel")):
        text, pictures = executed(path, more)
        same(picture in pictures, True, "%s among the outputs" % picture)
    else:
        print("SKIP: nbconvert or ipykernel not found (Debian packages python3-nbconvert and python3-ipykernel): the cells of %s "
              "run as a plain program" % name)
        text = program(name, *code, **more)
        if picture == "text/html":
            same(os.path.getsize(os.path.join(WORK.name, name.replace(".ipynb", ".html"))) > 10000, True, "replay")
    for word in words:
        same(word in text, True, "%r in what it prints" % word)
    return text


def executed(path, more):
    """Executes a notebook. Returns what it prints, and the kinds of its other outputs."""
    with tempfile.TemporaryDirectory() as folder:           # a notebook runs in the folder in which it is
        path = shutil.copy(path, folder)
        result = subprocess.run([sys.executable, "-B", "-m", "nbconvert", "--to", "notebook", "--execute", "--output-dir", folder, "--output",
                                 "executed", "--ExecutePreprocessor.timeout=600", path], capture_output=True, text=True, cwd=folder,
                                env=environment(**more))
        if result.returncode:
            raise AssertionError("%s: %s" % (os.path.basename(path), result.stderr[-1500:]))
        with open(os.path.join(folder, "executed.ipynb"), encoding="utf-8") as file:
            outputs = [output for cell in json.load(file)["cells"] if cell["cell_type"] == "code" for output in cell["outputs"]]
    return ("".join("".join(output["text"]) for output in outputs if output["output_type"] == "stream"),
            {kind for output in outputs for kind in output.get("data", ())})


@test("drum.ipynb runs and shows a replay")
def _():
    notebook("drum.ipynb")


@test("triaxial.ipynb runs: a dense sample has a peak, and both samples reach the critical angle")
def _():
    text = notebook("triaxial.ipynb")
    if text is not None:
        (peak, dense), (_, loose) = [[float(number) for number in pair] for pair in re.findall(
            r"peak angle = ([\d.]+) degrees, critical angle = ([\d.]+) degrees", text)]
        same((28 < peak < 37, 17 < dense < 24, 17 < loose < 24), (True, True, True), "angles %s, %s, %s" % (peak, dense, loose))


@test("every notebook of examples/python is executed")
def _():
    same(sorted(name for name in os.listdir(PYTHON) if name.endswith(".ipynb")), sorted(NOTEBOOKS))


# ---- the lessons ----

def lesson(name):
    """Compares what a lesson prints in Python with what it prints in C."""
    log, program = os.path.join(ROOT, "build", "out", name, "log"), os.path.join(ROOT, "build", name)
    if os.path.exists(log) and (not os.path.exists(program) or os.path.getmtime(log) >= os.path.getmtime(program)):
        with open(log) as file:
            text = file.read()
    else:
        text = subprocess.run([program], capture_output=True, text=True, cwd=WORK.name, env=dict(os.environ, OMP_NUM_THREADS="1")).stdout
    lines = [line.rstrip() for line in text.split("\n")]
    made = subprocess.run([sys.executable, "-B", os.path.join(PYTHON, "lessons.py"), name] + ([] if LONG else ["--short"]),
                          capture_output=True, text=True, env=dict(os.environ, OMP_NUM_THREADS="1"))
    if made.returncode:
        return "it ends with an error: " + made.stderr[-800:]
    rows = [line for line in made.stdout.split("\n") if line]
    for row in rows:
        if "..." in row:                                    # a time differs from run to run
            head, tail = row.split("...")
            found = any(line.startswith(head) and line.endswith(tail.strip()) for line in lines)
        else:
            found = any(line == row or line.startswith(row + "  ") or row.startswith("Gamma") and line.startswith(row) for line in lines)
        if not found:
            return "C does not print %r" % row
    if LONG:
        measured = [line for line in lines if re.search(r" (within|to) [\d.e-]+", line[60:]) or " +- " in line]
        lost = [line for line in measured if not any(line.startswith(row.split("...")[0]) for row in rows)
                and not re.search(r"exam, lines|step with all five|^trials |^advice |^passed |^FOUND |s per s|as it is|step |softer|stiffer|springs|friction *[\d.]+e|active", line)]
        if lost:
            return "Python does not print %r" % lost[0]
    return "" if rows else "it prints nothing"


def main():
    words = " ".join(sys.argv[1:])
    passed = failed = 0

    def report(name, error, seconds):
        nonlocal passed, failed
        passed, failed = passed + (not error), failed + bool(error)
        print("%s %s%s" % ("FAILED" if error else "ok    ", name, ": " + error if error else ""), "(%.1f s)" % seconds if seconds > 1 else "", flush=True)

    spec = importlib.util.spec_from_file_location("lessons", os.path.join(PYTHON, "lessons.py"))
    lessons = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(lessons)
    def run(tests):
        for name, function in tests:
            if words in name:
                began = time.time()
                try:
                    function()
                    error = ""
                except Exception as caught:
                    line = [frame.lineno for frame in traceback.extract_tb(caught.__traceback__) if frame.filename == __file__]
                    error = "line %s: %s: %s" % (", ".join(map(str, line[1:])), type(caught).__name__, caught)
                report(name, error, time.time() - began)

    began = time.time()
    with concurrent.futures.ThreadPoolExecutor(int(os.environ.get("JOBS", os.cpu_count() or 1))) as pool:
        loading = pool.submit(timed, dem.load)              # compiles, beside the tests that need no library
        run(TESTS[:3])
        error, seconds = loading.result()
        if error:
            sys.exit("check.py: " + error)
        print("# compiled and loaded in %.1f s" % seconds)
        # the longest first, beside the other tests
        order = ["08_drum", "06_hopper", "05_silo", "10_clusters", "12_effects", "07_brazil_nut", "11_advise",
                 "02_pile", "01_bounce", "03_incline", "04_own_law", "09_moving_wall"]
        same(sorted(order), sorted(lessons.LESSONS), "lessons")
        names = {name: "lesson %s prints in Python what it prints in C, digit for digit" % name for name in order}
        futures = {name: pool.submit(timed, lesson, name) for name in order if words in names[name]}
        called = set()

        def recorded(name, function):
            def call(*arguments):
                called.add(name)
                return function(*arguments)
            return call
        functions = {name: getattr(dem._lib, name) for name, *_ in dem._FUNCTIONS}
        for name, function in functions.items():
            setattr(dem._lib, name, recorded(name, function))
        run(TESTS[3:])
        if not words:
            lost = sorted(set(functions) - called - {"dem_body_id_get"})       # dempy_ids calls it in C
            report("every function of the library is called by a test", lost and "not called: " + ", ".join(lost), 0)
        for name, future in futures.items():
            error, seconds = future.result()
            report(names[name], error, seconds)
    print("%d passed, %d failed" % (passed, failed))
    return failed > 0 or not passed


def timed(function, *arguments):
    began = time.time()
    try:
        return function(*arguments), time.time() - began
    except Exception as error:
        return "%s: %s" % (type(error).__name__, error), time.time() - began


if __name__ == "__main__":
    sys.exit(main())
