"""python3 tests/python/walk.py [BEGIN END] : calls every function of dem.py with wrong values in every argument.

No call may end the process, and each exception must be a dem.Error. Child processes make many calls each and note the number of
the call that they begin, so that one that dies names its call; the walk continues behind it. The last line is
"N calls, N refused, N accepted, N wrong". BEGIN END: makes these calls in this process."""
import copy
import ctypes
import gc
import inspect
import io
import os
import pickle
import subprocess
import sys
import tempfile
import time
import warnings

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
os.environ.setdefault("DEM_BUILD", os.path.join(ROOT, "build"))
sys.path.insert(0, os.path.join(ROOT, "examples", "python"))
sys.dont_write_bytecode = True
import dem  # noqa: E402
try:
    import numpy
except ImportError:
    numpy = None

BOX, CELL = (-1, -1, 0, 1, 1, 1), (0, 0, 0, 1, 1, 1)


class Scene:
    """A world with one object of each kind; they are made when they are used."""

    def __init__(self):
        self.world = dem.World(gravity=(0, 0, -9.81), groups="a b", body_reals="heat", threads=1)
        self.glass = self.world.material(density=2500, young=1e7, poisson=0.25, restitution=0.5, friction=0.5)
        self.world.wall_plane(self.glass, (0, 0, 0), (0, 0, 1))
        self.ball = self.world.sphere(self.glass, 0.01, (0, 0, 0.5))

    def get(self, kind):
        world = self.world
        return {
            "World": lambda: world, "Material": lambda: self.glass, "Body": lambda: self.ball, "Group": lambda: world.group("a"),
            "Wall": lambda: world.wall_plane(self.glass, (0, 0, 5), (0, 0, -1)), "Shape": lambda: world.shape_ellipsoid((3e-3, 2e-3, 2e-3)),
            "Field": lambda: world.field(box=BOX, cells=(2, 2, 2), interval=1e-3), "Rows": lambda: world.bodies,
            "Feed": lambda: world.feed(material=self.glass, radius=[1e-3], amount=[1], limited=1, rate=10, box=BOX),
            "Outlet": lambda: world.outlet(box=(-1, -1, -9, 1, 1, -8)), "Replay": lambda: world.replay("walk.html"),
            "Output": lambda: world.output_every("vtp", "walk_####.vtp", 1), "Slabs": lambda: world.slabs(axis=0, count=1),
            "Joint": joint}[kind]()


def joint():
    world = dem.World(response="impulses", dt=1e-3, orientations=1)
    arm = world.sphere(world.material(density=2500), 0.1, (1, 0, 0))
    return world.joint(kind="revolute", a=arm, point=(0, 0, 0), axis=(0, 0, 1))


def closed():
    scene = Scene()
    scene.world.close()
    return scene


MESH = dict(vertices=[(0, 0, 0), (1, 0, 0), (0, 1, 0)], triangles=[(0, 1, 2)])
VALID = {       # by the name of an argument
    "material": lambda s: s.glass, "a": lambda s: s.glass, "b": lambda s: s.glass, "shape": lambda s: s.get("Shape"),
    "shapes": lambda s: [s.get("Shape")], "group": lambda s: s.get("Group"), "sieve": lambda s: s.get("Wall"), "world": lambda s: s.world,
    "radius": 0.01, "position": (0, 0, 1), "positions": [(0, 0, 2), (0, 0, 3)], "points": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
    "semi_axes": (1, 2, 3), "region": BOX, "box": BOX, "count": 2, "seed": 1, "name": "a", "path": "walk.txt", "format": "stl",
    "mesh": MESH, "profile": dict(vertices=[(0, 0), (1, 0)], segments=[(0, 1)]), "point": (0, 0, 0), "normal": (0, 0, 1), "axis": (0, 0, 1),
    "inside": 1, "radii": [0.1, 0.2], "heights": [0, 1], "from_": (0, 0, 0), "to": (0, 0, 1), "radius_from": 1, "radius_to": 2, "share": 1,
    "sizes": dict(kind="uniform", min=1, max=2), "padding": 0.001, "selection": {}, "velocity": (0, 0, 0), "spin": (0, 0, 0), "fixed": 0,
    "member": 1, "reals": [1.0], "radius_a": 1, "radius_b": 1, "class_count": 3, "temperature": 1e-3, "kind": 0, "interval": 1,
    "seconds": 1e-4, "end": 1e-4, "time": 1e-4, "steps": 1, "dt": 1e-5, "gravity": (0, 0, 0), "number": 0, "value": 1.0, "hardness": 1e9,
    "coefficient": 1e-4, "data": "x y z r\n1 2 3 0.1\n", "text": "x", "c": lambda s: dem.Contact(), "f": lambda s: dem.ContactForce(),
    "memory": lambda s: (dem.Real*8)(), "hold": 0, "q": (1, 0, 0, 0), "v": (1, 0, 0), "angle": 1, "result": 0, "function": lambda s: lambda *_: None,
    "parts": lambda s: [], "scale": 1, "rotation": (1, 0, 0, 0), "translation": (0, 0, 0), "shift": (0, 0, 0), "i": 0, "j": 0, "k": 0,
    "index": 0, "changes": "", "allowed": "", "first": 0, "source": "int one(void) { return 1; }", "trials": lambda s: dem.Trials(),
    "done": 0.5, "seconds_left": 1, "gap": 0, "part": "a", "object": "a", "motor": 0, "speed": 0, "torque": 0, "surface_velocity": (0, 0, 0)}


def valid(name, scene):
    value = VALID.get(name)
    return value(scene) if callable(value) else value


def foreign():
    other = Scene()
    return other.ball


WRONG = [("None", lambda: None), ("int", lambda: 7), ("a large int", lambda: 2**70), ("text", lambda: "x"), ("float", lambda: 1.5),
         ("nan", lambda: float("nan")), ("list", lambda: [1, "a"]), ("ragged list", lambda: [[1, 2], [3]]), ("empty list", lambda: []),
         ("dict", lambda: {"a": 1}), ("object", object), ("function", lambda: lambda *_: "x"), ("type", lambda: dem.Vec3),
         ("bytes", lambda: b"a\0b"), ("module", lambda: dem), ("body of another world", foreign), ("body of a closed world", lambda: closed().ball),
         ("closed world", lambda: closed().world), ("other array", lambda: numpy.zeros((2, 5), "f4") if numpy else memoryview(bytearray(8))),
         ("array of ints", lambda: numpy.arange(6).reshape(2, 3) if numpy else memoryview((ctypes.c_int*6)())),
         ("other struct", lambda: dem.Counters()), ("set", lambda: {1, 2}), ("complex", lambda: 1j)]


def parameters(function):
    """(name, whether it must be given) of the arguments of a function."""
    return [(name, p.default is p.empty) for name, p in inspect.signature(function).parameters.items()
            if name != "self" and p.kind not in (p.VAR_POSITIONAL, p.VAR_KEYWORD)]


SKIP = {("module", "load"), ("module", "build")}


def calls():
    """(label, function of a scene and a wrong value) of all calls, and whether they need a scene."""
    found = []

    def add(label, function, scene=True):
        found.append((label, function, scene))

    def method(kind, name, arguments, wrong, get):
        def call(scene, value):
            given = {key: valid(key, scene) for key, needed in arguments if needed}
            if "progress" in dict(arguments):
                given["progress"] = lambda *_: True         # ends what would run for ages
            if name == "spheres_pack":
                given["count"] = 10
            if wrong:
                given[wrong] = min(value, 1) if wrong == "duration" and isinstance(value, int) else value
            return getattr(get(scene), name)(**given)
        return call
    kinds = [dem.World, dem.Replay, dem.Slabs, dem.Rows] + [kind for kind in dem.structs if issubclass(kind, dem.Id)]
    for kind in kinds:
        for name in dir(kind):
            member = inspect.getattr_static(kind, name)
            if name[0] == "_" or isinstance(member, (classmethod, staticmethod)) or name in ("id", "slot", "generation"):
                continue
            label = "%s.%s" % (kind.__name__, name)
            for about, get in (("", lambda s, kind=kind: s.get(kind.__name__)), (" of a closed world", lambda s, kind=kind: closed_of(s, kind))):
                if isinstance(member, property):
                    add(label + about, lambda s, v, get=get, name=name: repr(getattr(get(s), name)))
                elif callable(getattr(kind, name)):
                    if not about:
                        add("dem.%s({})" % label, lambda s, v, kind=kind, name=name: getattr(kind, name)(v), False)
                    add(label + "()" + about, method(kind, name, parameters(getattr(kind, name)), None, get))
            if isinstance(member, property):
                add("%s = {}" % label, lambda s, v, kind=kind, name=name: setattr(s.get(kind.__name__), name, v))
            elif callable(getattr(kind, name)):
                arguments = parameters(getattr(kind, name))
                for wrong, _ in arguments:
                    add("%s(%s={})" % (label, wrong), method(kind, name, arguments, wrong, lambda s, kind=kind: s.get(kind.__name__)))
        for name in ("__getitem__", "__eq__", "__contains__", "anything"):
            if name == "anything":
                add("%s.anything = {}" % kind.__name__, lambda s, v, kind=kind: setattr(s.get(kind.__name__), "anything", v))
            elif hasattr(kind, name):
                add("%s.%s({})" % (kind.__name__, name), lambda s, v, kind=kind, name=name: getattr(s.get(kind.__name__), name)(v))
        for about, function in (("repr", repr), ("copy", copy.copy), ("deepcopy", copy.deepcopy), ("pickle", pickle.dumps), ("len", len_)):
            add("%s of a %s" % (about, kind.__name__), lambda s, v, kind=kind, function=function: function(s.get(kind.__name__)))

    for name in dem.WorldDesc.kinds:
        def create(scene, value, name=name):
            world = dem.World(**{"law": lambda *_: None, "law_stiffness": 1e4, name: value} if name.startswith("law") else {name: value})
            glass = world.material(density=2500, young=1e7, poisson=0.25, restitution=0.5)
            world.wall_plane(glass, (0, 0, 0), (0, 0, 1))
            world.sphere(glass, 0.01, (0, 0, 0.0099))
            world.step(3)
        add("World(%s={})" % name, create, False)
    for name, function in sorted(vars(dem).items()):
        if inspect.isfunction(function) and name[0] != "_" and ("module", name) not in SKIP:
            arguments = parameters(function)
            for wrong, _ in arguments:
                def call(scene, value, function=function, arguments=arguments, wrong=wrong, name=name):
                    given = {key: valid(key, scene) for key, needed in arguments if needed}
                    if name == "ellipsoids_contact":
                        given.update(a=((0, 0, 0), (1, 1, 1)), b=((1, 0, 0), (1, 1, 1)))
                    elif name == "quat_multiply":
                        given.update(a=(1, 0, 0, 0), b=(1, 0, 0, 0))
                    given[wrong] = value
                    return function(**given)
                add("dem.%s(%s={})" % (name, wrong), call)
    for kind in dem.structs:
        add("dem.%s({})" % kind.__name__, lambda s, v, kind=kind: used(kind(v)), False)
        add("dem.%s.make({})" % kind.__name__, lambda s, v, kind=kind: used(kind.make(v)), False)
        add("dem.%s(anything={})" % kind.__name__, lambda s, v, kind=kind: kind(**{"anything": v}), False)
        add("dem.%s()[{}]" % kind.__name__, lambda s, v, kind=kind: kind()[v], False)
        add("dem.%s() == {}" % kind.__name__, lambda s, v, kind=kind: kind() == v, False)
        for name in kind.kinds:
            add("dem.%s(%s={})" % (kind.__name__, name), lambda s, v, kind=kind, name=name: used(kind(**{name: v})), False)
            add("dem.%s().%s = {}" % (kind.__name__, name), lambda s, v, kind=kind, name=name: assigned(kind(), name, v), False)
    return found


def len_(value):
    return len(value) if hasattr(value, "__len__") else 0


def closed_of(scene, kind):
    thing = scene.get(kind.__name__)
    if isinstance(thing, dem.Id):
        thing.world.close()
    elif isinstance(thing, dem.Rows):
        scene.world.close()
    else:
        thing.close()
    return thing


def used(struct):
    """Reads all of a struct."""
    repr(struct)
    for name in struct.kinds:
        getattr(struct, name)
    return struct


def assigned(struct, name, value):
    setattr(struct, name, value)
    used(struct)


def walk(begin, end, note):
    """Makes the calls from begin to end; prints what is wrong with them. note(number): before each call."""
    warnings.simplefilter("ignore")
    refused = accepted = number = 0
    silent = io.StringIO()
    for label, function, needs in calls():
        single = "{}" not in label
        for what, make in [("", lambda: None)] if single else WRONG:
            number += 1
            if not begin <= number < end:
                continue
            note(number)
            began = time.time()
            scene = Scene() if needs else None
            value, out = make(), sys.stdout
            sys.stdout = silent
            error = None
            try:
                function(scene, value)
                if scene and scene.world._at is not None:
                    scene.world.step(1)
            except BaseException as caught:
                error = caught
            finally:
                sys.stdout = out
            name = label.format(what)
            if error is None:
                accepted += 1
            elif isinstance(error, dem.Error):
                refused += 1
                if "ctypes" in str(error) or "argument 2" in str(error):
                    print("WRONG %d %s: the message is that of ctypes: %s" % (number, name, error))
            else:
                print("WRONG %d %s: %s: %s" % (number, name, type(error).__name__, str(error)[:200]))
            if time.time() - began > 5:
                print("SLOW %d %s: %.1f s" % (number, name, time.time() - began))
            error = scene = value = None
        if number % 50 == 0:
            gc.collect()
    print("DONE %d %d" % (refused, accepted), flush=True)


def main(jobs=2, limit=60):
    """Walks in child processes; returns (calls, refused, accepted, [what is wrong])."""
    dem.load()                                              # compiled once, before the children need it
    total = sum(1 if "{}" not in label else len(WRONG) for label, _, _ in calls())
    parts = 4*jobs
    ranges = [(1 + i*total//parts, 1 + (i + 1)*total//parts) for i in range(parts)]
    refused = accepted = 0
    wrong, running = [], []
    with tempfile.TemporaryDirectory() as work:
        while ranges or running:
            while ranges and len(running) < jobs:
                begin, end = ranges.pop(0)
                folder = tempfile.mkdtemp(dir=work)
                log = os.path.join(folder, "log")
                with open(log, "w") as out:
                    child = subprocess.Popen([sys.executable, "-B", os.path.abspath(__file__), str(begin), str(end)], stdout=out,
                                             stderr=subprocess.STDOUT, cwd=folder, env=dict(os.environ, MALLOC_PERTURB_="165"))
                running.append((child, begin, end, folder, time.time()))
            time.sleep(0.05)
            for item in list(running):
                child, begin, end, folder, began = item
                code = child.poll()
                if code is None and time.time() - began > limit:
                    child.kill()
                    code = child.wait()
                if code is None:
                    continue
                running.remove(item)
                with open(os.path.join(folder, "log"), errors="replace") as file:
                    lines = file.read().split("\n")
                for line in lines:
                    if line.startswith("DONE"):
                        refused, accepted = refused + int(line.split()[1]), accepted + int(line.split()[2])
                    elif line.startswith(("WRONG", "SLOW")):
                        wrong.append(line)
                if not any(line.startswith("DONE") for line in lines):
                    at = os.path.join(folder, "at")
                    number = int(open(at).read() or begin) if os.path.exists(at) else begin
                    wrong.append("WRONG %d %s: the process ended with %s\n%s" % (number, name_of(number), code, "\n".join(lines[-6:])))
                    if number + 1 < end and len(wrong) < 50:
                        ranges.append((number + 1, end))
    return total, refused, accepted, wrong


def name_of(number):
    for label, _, _ in calls():
        for what in [""] if "{}" not in label else [name for name, _ in WRONG]:
            number -= 1
            if not number:
                return label.format(what)
    return "?"


if __name__ == "__main__":
    if len(sys.argv) > 2:
        place = os.open("at", os.O_CREAT | os.O_WRONLY)
        walk(int(sys.argv[1]), int(sys.argv[2]), lambda number: os.pwrite(place, b"%-8d" % number, 0))
        sys.stdout.flush()
        os._exit(0)
    total, refused, accepted, wrong = main()
    print("\n".join(wrong))
    print("%d calls, %d refused, %d accepted, %d wrong" % (total, refused, accepted, len(wrong)))
    sys.exit(bool(wrong))
