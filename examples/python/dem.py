"""dem.py gives dem.h to Python: ctypes and the standard library, nothing else. MIT licence.

    import dem
    world = dem.World(gravity=(0, 0, -9.81))
    glass = world.material(density=2500, young=1e7, poisson=0.25, restitution=0.5, friction=0.5)
    world.wall_plane(glass, (0, 0, 0), (0, 0, 1))
    ball = world.sphere(glass, 0.01, (0, 0, 0.1))
    world.run(0.5)
    print(ball.state.position)

make.py made this file from dem.h and base.py: change those, then `make python`. docs/python.md is the manual. The texts
below are the comments of dem.h with the names of Python. Rules of names:

    dem_world_step(world, 1)                world.step(1)           functions of a world are methods
    dem_sphere_add(world, ...)              world.sphere(...)       _add, _get, _open, _create are dropped
    dem_counters_get(world)                 world.counters          _get without arguments: a property
    dem_wall_loads_get(world, wall, &l)     wall.loads              functions of an id are its methods
    dem_body_get(world, body, &state)       body.state              named after the struct that it returns
    dem_body_set(world, body, &state)       body.set(velocity=...)  only these fields change
    dem_quat_multiply(a, b)                 dem.quat_multiply(a, b) others are functions of the module
    dem_vec3_make(1, 2, 3)                  dem.Vec3(1, 2, 3), or the tuple (1, 2, 3)
    DEM_NORMAL_LINEAR                       dem.NormalLaw.LINEAR, or the word "linear"
    DEM_ERROR_TIME_STEP                     raises dem.TimeStepError, whose text is the error message
    struct dem_motion                       dem.Motion, or keyword arguments: wall.motion_set(kind="rotating", ...)
"""
import builtins
import ctypes
import enum
import functools
import gc
import hashlib
import html
import io
import math
import operator
import os
import platform
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import types
import warnings
import weakref
try:
    import _signal              # signal.signal takes 15 us
except ImportError:
    _signal = signal
_refs = sys.getrefcount
VERSION_MAJOR = 0
VERSION_MINOR = 1
VERSION_PATCH = 0
GROUPS = 32
BODY_REALS = 8
LAW_MEMORY = 16
SIEVES = 32
POLYHEDRON_FACES = 100
RINGS = 12
RAIL_X = 1
RAIL_Y = 2
RAIL_Z = 4
RAIL_SPIN_X = 8
RAIL_SPIN_Y = 16
RAIL_SPIN_Z = 32
RAIL_ALL = 63
CLASSES = 16
RESIDENCE_BINS = 64
OBSERVABLES = 8
TRIALS = 8
IMPACT_BINS = 120
IMPACT_LIMITS = 121
REPLAY_VALUES = 16
OUTPUT_COLUMNS = 32
EFFECTS = 19
VERSION = VERSION_MAJOR*10000 + VERSION_MINOR*100 + VERSION_PATCH
__version__ = "%d.%d.%d" % (VERSION_MAJOR, VERSION_MINOR, VERSION_PATCH)
# inline functions of dem.h, which the library exports under other names
_INLINE = r"""
dem_quat dempy_quat_multiply(dem_quat a, dem_quat b) { return dem_quat_multiply(a, b); }
dem_vec3 dempy_quat_rotate(dem_quat q, dem_vec3 v) { return dem_quat_rotate(q, v); }
dem_vec3 dempy_quat_unrotate(dem_quat q, dem_vec3 v) { return dem_quat_unrotate(q, v); }
dem_vec3 dempy_memory_rotate(const dem_contact *c, dem_vec3 v) { return dem_memory_rotate(c, v); }
void dempy_law_load(const dem_contact *c, dem_contact_force *f, dem_real hold) { dem_law_load(c, f, hold); }
void dempy_law_hertz(const dem_contact *c, dem_real *memory, dem_contact_force *f) { dem_law_hertz(c, memory, f); }
void dempy_law_linear(const dem_contact *c, dem_real *memory, dem_contact_force *f) { dem_law_linear(c, memory, f); }
void dempy_law_hysteretic(const dem_contact *c, dem_real *memory, dem_contact_force *f) { dem_law_hysteretic(c, memory, f); }
void dempy_law_viscous(const dem_contact *c, dem_real *memory, dem_contact_force *f) { dem_law_viscous(c, memory, f); }
void dempy_law_step(const dem_contact *c, dem_real *memory, dem_contact_force *f) { dem_law_step(c, memory, f); }
void dempy_law_spring(const dem_contact *c, dem_real *memory, dem_contact_force *f) { dem_law_spring(c, memory, f); }
void dempy_law_mindlin(const dem_contact *c, dem_real *memory, dem_contact_force *f) { dem_law_mindlin(c, memory, f); }
void dempy_law_mindlin_rescaled(const dem_contact *c, dem_real *memory, dem_contact_force *f) { dem_law_mindlin_rescaled(c, memory, f); }
void dempy_law_roll_step(const dem_contact *c, dem_real *memory, dem_contact_force *f) { dem_law_roll_step(c, memory, f); }
void dempy_law_roll_constant(const dem_contact *c, dem_real *memory, dem_contact_force *f) { dem_law_roll_constant(c, memory, f); }
void dempy_law_roll_epsd(const dem_contact *c, dem_real *memory, dem_contact_force *f) { dem_law_roll_epsd(c, memory, f); }
void dempy_law_twist(const dem_contact *c, dem_real *memory, dem_contact_force *f) { dem_law_twist(c, memory, f); }
"""
_LAW_NEEDS = {      # numbers of contact history that a built-in law needs, and leading vectors among them
    'law_hertz': (0, 0),
    'law_linear': (0, 0),
    'law_hysteretic': (1, 0),
    'law_viscous': (0, 0),
    'law_step': (0, 0),
    'law_spring': (3, 1),
    'law_mindlin': (4, 1),
    'law_mindlin_rescaled': (4, 1),
    'law_roll_step': (0, 0),
    'law_roll_constant': (3, 1),
    'law_roll_epsd': (3, 1),
    'law_twist': (1, 0),
}
_LAW_READS = {      # fields of the force that a friction or rolling law reads, which a normal law sets
    'law_viscous': ('ct', 'load'),
    'law_step': ('kt', 'ct', 'load'),
    'law_spring': ('kt', 'ct', 'load'),
    'law_mindlin': ('kt', 'kt_step', 'ct', 'load'),
    'law_mindlin_rescaled': ('kt', 'kt_step', 'ct', 'load'),
    'law_roll_step': ('load',),
    'law_roll_constant': ('load',),
    'law_roll_epsd': ('slope', 'slope_step', 'load'),
    'law_twist': ('load',),
}

# ---- errors, one for each result ------------------------------------------------------------------


class Result(enum.IntEnum):
    """The result of a call. World.error returns the message, dem.result_name the name."""
    OK = 0
    # a value is out of range, an id is invalid, or a call is not allowed here
    ERROR_ARGUMENT = 1
    # the allocator returned None
    ERROR_MEMORY = 2
    # a file cannot be opened, read, written or renamed
    ERROR_FILE = 3
    # the contents of a file are damaged, or of another format, version or scene
    ERROR_FORMAT = 4
    # the time step is too large for a contact, a spin, or the speed of a body or wall
    ERROR_TIME_STEP = 5
    # a state or force is not finite, an overlap is larger than a radius, or a motion gives an impossible pose
    ERROR_UNSTABLE = 6
    # a function of yours stopped the run, World.settle ran out of time, or a step with impulses exceeded the
    # tolerance (unsolved_stops)
    ERROR_STOPPED = 7


class Error(Exception):
    """A call of dem.h has failed. The text is the error message of dem.h: the function, what is wrong with the value,
    the limit, the likely cause, the remedy. result: the dem.Result."""
    result = None


_ERRORS = {}


class ArgumentError(Error, ValueError):
    """a value is out of range, an id is invalid, or a call is not allowed here"""
    result = Result.ERROR_ARGUMENT


_ERRORS[1] = ArgumentError


class MemoryError(Error, MemoryError):
    """the allocator returned null"""
    result = Result.ERROR_MEMORY


_ERRORS[2] = MemoryError


class FileError(Error, OSError):
    """a file cannot be opened, read, written or renamed"""
    result = Result.ERROR_FILE


_ERRORS[3] = FileError


class FormatError(Error, ValueError):
    """the contents of a file are damaged, or of another format, version or scene"""
    result = Result.ERROR_FORMAT


_ERRORS[4] = FormatError


class TimeStepError(Error):
    """the time step is too large for a contact, a spin, or the speed of a body or wall"""
    result = Result.ERROR_TIME_STEP


_ERRORS[5] = TimeStepError


class UnstableError(Error):
    """a state or force is not finite, an overlap is larger than a radius, or a motion gives an impossible pose"""
    result = Result.ERROR_UNSTABLE


_ERRORS[6] = UnstableError


class StoppedError(Error):
    """a function of yours stopped the run, dem_world_settle ran out of time, or a step with impulses exceeded the
    tolerance (unsolved_stops)
    """
    result = Result.ERROR_STOPPED


_ERRORS[7] = StoppedError


class ArgumentTypeError(Error, TypeError):
    """An argument or a field has a wrong type. The text names the call, the argument, what is given and what is wanted."""
    result = Result.ERROR_ARGUMENT


class ArgumentRangeError(Error, OverflowError):
    """A number does not fit into the type of C."""
    result = Result.ERROR_ARGUMENT


class FieldError(Error, AttributeError):
    """An assignment to what cannot be set. The text names the call that changes it."""
    result = Result.ERROR_ARGUMENT


class LoadError(Error, ImportError):
    """The library cannot be compiled or loaded."""


class NoSuchError(ArgumentError, IndexError):
    """There is no body, element or row of this number."""


class NoFieldError(ArgumentError, AttributeError):
    """There is no field or attribute of this name."""
# ---- the shared library ------------------------------------------------------------------------

if os.environ.get("DEM_REAL", "") not in ("", "float", "double"):
    raise LoadError("dem.py: the environment variable DEM_REAL is %r, must be float or double" % os.environ["DEM_REAL"])
Real = ctypes.c_float if os.environ.get("DEM_REAL") == "float" else ctypes.c_double
_NAN = float("nan")
# dem_trials_run calls dem_world_run(copy, seconds, 0, 0). The macro replaces the first 0 of such a call by a progress
# function, so that Ctrl-C stops it. The definition of dem_world_run stays as it is.
_SOURCE = """
#include <stddef.h>
#include "dem.h"
dem_progress_fn dempy_progress;
static int dempy_of_trial(const dem_world *world, double done, double seconds_left, void *user) {
    return dempy_progress && done < 1 ? dempy_progress(world, done, seconds_left, user) : 0;
}
#define DEMPY_0 dempy_of_trial
#define DEMPY_dem_progress_fn dem_progress_fn
#define dem_world_run(world, seconds, progress, user) dem_world_run(world, seconds, DEMPY_##progress, user)
#define DEM_IMPLEMENTATION
#include "dem.h"
"""


# The arrays of all bodies in the order of their slots, and what sets or reads them together.
_ROWS = r"""
#include <stdlib.h>
#include <string.h>
static uint32_t *dempy_ranks(const dem_bodies *b) {
    uint32_t most = 0, sum = 0, k, *rank;
    int i;
    for (i = 0; i < b->count; i++) if (b->slots[i] > most) most = b->slots[i];
    rank = (uint32_t *)calloc((size_t)most + 1, sizeof *rank);
    if (!rank) return 0;
    for (i = 0; i < b->count; i++) rank[b->slots[i]] = 1;
    for (k = 0; k <= most; k++) { const uint32_t here = rank[k]; rank[k] = sum; sum += here; }
    return rank;
}
int dempy_rows(const dem_world *w, size_t field, size_t width, int count, char *out) {
    const dem_bodies b = dem_bodies_get(w);
    const char *from;
    uint32_t *rank;
    int i;
    memcpy(&from, (const char *)&b + field, sizeof from);
    if (!from || count != b.count) return 1;
    if (!(rank = dempy_ranks(&b))) return 2;
    for (i = 0; i < b.count; i++) memcpy(out + width*rank[b.slots[i]], from + width*(size_t)i, width);
    free(rank);
    return 0;
}
int dempy_ids(const dem_world *w, int count, dem_body *out) {
    const dem_bodies b = dem_bodies_get(w);
    uint32_t *rank;
    int i;
    if (count != b.count) return 1;
    if (!(rank = dempy_ranks(&b))) return 2;
    for (i = 0; i < b.count; i++) out[rank[b.slots[i]]] = dem_body_id_get(w, i);
    free(rank);
    return 0;
}
int dempy_put(dem_world *w, int count, const dem_body *ids, const dem_real *x, const dem_real *v, const dem_real *s) {
    const dem_real *all = x ? x : v ? v : s;
    int i;
    for (i = 0; i < 3*count; i++) if (!(all[i] >= -1e15 && all[i] <= 1e15)) return -1 - i/3;
    for (i = 0; i < count; i++) {
        dem_body_state state;
        int result = dem_body_get(w, ids[i], &state);
        if (x) state.position = dem_vec3_make(x[3*i], x[3*i + 1], x[3*i + 2]);
        if (v) state.velocity = dem_vec3_make(v[3*i], v[3*i + 1], v[3*i + 2]);
        if (s) state.spin = dem_vec3_make(s[3*i], s[3*i + 1], s[3*i + 2]);
        if (!result) result = dem_body_set(w, ids[i], &state);
        if (result) return result;
    }
    return 0;
}
"""


def _compiler(folder):
    """The command that compiles a shared library: the compiler and those flags that it accepts."""
    command = os.environ.get("CC", "cc").split() + os.environ.get("DEM_CFLAGS", "-O2").split()
    if not shutil.which(command[0]):
        raise LoadError("dem.py: the C compiler %r was not found, so dem.h cannot be compiled; install one (Debian "
                          "package gcc), or set CC, or pass a library to dem.load" % command[0])
    if Real is ctypes.c_float:
        command.append("-DDEM_REAL=float")
    probe = os.path.join(folder, "probe.c")
    threads = "#include <omp.h>\nint one(void) { return omp_get_max_threads(); }\n"
    for flags, text in ((["-shared", "-fPIC"], "int one;\n"), (["-ffp-contract=off"], "int one;\n"), (["-fopenmp"], threads),
                        (["-Xpreprocessor", "-fopenmp", "-lomp"], threads)):
        if "-lomp" in flags and "-fopenmp" in command:
            continue
        with open(probe, "w") as file:
            file.write(text)
        if not subprocess.run(command + [probe, "-o", probe + ".so"] + flags, capture_output=True).returncode:
            command += flags
    return command


def _header(header=None):
    """The path of dem.h."""
    places = [header or os.environ.get("DEM_H")] if header or "DEM_H" in os.environ else [
        os.path.join(here, *up, "dem.h") for here in (os.path.dirname(os.path.abspath(__file__)), os.path.dirname(
            os.path.realpath(__file__))) for up in ((), ("..", ".."))] + ["/usr/local/include/dem.h"]
    found = next((os.path.abspath(place) for place in places if os.path.isfile(place)), None)
    if not found:
        raise LoadError("dem.py: dem.h was not found (%s); copy it beside dem.py, or set DEM_H" % ", ".join(places))
    return found


def _folder(header, folder):
    """The folder in which libraries are kept."""
    folder = folder or os.environ.get("DEM_BUILD") or os.path.join(os.path.dirname(header), "build")
    try:
        os.makedirs(folder, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError:
        folder = os.path.join(os.path.expanduser("~"), ".cache", "dem")
        os.makedirs(folder, exist_ok=True)
    return folder


def build(header=None, folder=None):
    """Compiles dem.h to a shared library, unless that has been done before, and returns its path.

    header: path of dem.h. Without it: the environment variable DEM_H, or dem.h in the folder of dem.py, two folders
    above, or in /usr/local/include. folder: where the library is kept. Without it: DEM_BUILD, or the folder build
    beside dem.h, or ~/.cache/dem if that cannot be written. The environment variables CC (cc) and DEM_CFLAGS (-O2)
    give the compiler and its flags; DEM_REAL=float compiles in single precision."""
    header, folder = (value if value is None else os.fsdecode(_text_of(value, "dem.build: " + name))
                      for name, value in (("header", header), ("folder", folder)))
    header = _header(header)
    folder = _folder(header, folder)
    source = _SOURCE + _INLINE + _ROWS + "const size_t dempy_sizes[] = {%s, 0};\n" % ", ".join(
        "sizeof(%s)" % kind.c_name for kind in structs)
    with open(header, "rb") as file:
        text = file.read()
    flags = [os.environ.get("CC", "cc"), os.environ.get("DEM_CFLAGS", "-O2"), str(Real), sys.platform, platform.machine()]
    digest = hashlib.sha256(text + source.encode() + "\n".join(flags).encode()).hexdigest()[:16]
    path = os.path.join(folder, "libdem-%s.so" % digest)
    if os.path.exists(path):
        return path
    with tempfile.TemporaryDirectory(dir=folder) as work:
        command = _compiler(work)
        with open(os.path.join(work, "dem.c"), "w") as file:
            file.write(source.replace('"dem.h"', '"%s"' % os.path.basename(header)))
        command += ["-I" + os.path.dirname(header), os.path.join(work, "dem.c"), "-o", os.path.join(work, "dem.so"), "-lm"]
        if "-lomp" in command:
            command.append(command.pop(command.index("-lomp")))
        print("dem.py: compiling %s, once; this takes 10 to 60 s" % header, file=sys.stderr)
        result = subprocess.run(command, capture_output=True, text=True)
        if result.returncode:
            raise LoadError("dem.py: dem.h does not compile: %s\n%s" % (" ".join(command), result.stderr[-2000:]))
        os.replace(os.path.join(work, "dem.so"), path)      # complete or absent, also if several processes compile
    return path


class _Library:
    """The functions of dem.h. The first use of one compiles and loads the library."""

    def __getattr__(self, name):
        with _LOADING:
            if "dem_world_step" not in self.__dict__:
                load()
        if name not in self.__dict__:
            raise AttributeError("%s has no %s, an inline function of dem.h; libraries that dem.build() makes have it"
                                 % (self.__dict__.get("path"), name))
        return self.__dict__[name]


_LOADING = threading.RLock()
_lib = _Library()


def load(path=None):
    """Loads the library at `path`, or without a path the one that dem.build() returns. Other functions call it
    automatically. A library of another version, precision or layout of structs raises ImportError."""
    path = os.fsdecode(_text_of(path, "dem.load: path")) if path is not None else build()
    try:
        library = ctypes.CDLL(path)
    except OSError as error:
        raise LoadError("dem.load: %s" % error) from None
    for function, result, arguments, name, names in _FUNCTIONS:
        try:
            entry = getattr(library, function)
        except AttributeError:          # inline functions are in libraries that dem.build() has made
            if function.startswith("dempy_"):
                continue
            raise LoadError("dem.py: %s has no function %s; it is not a library of this dem.h" % (path, function)) from None
        entry.restype, entry.argtypes = result, arguments
        _lib.__dict__[function] = _checked(entry, name, names, arguments)
    if hasattr(library, "dempy_sizes"):
        sizes = (ctypes.c_size_t*(len(structs) + 1)).in_dll(library, "dempy_sizes")
        for size, kind in zip(sizes, structs):
            if size != ctypes.sizeof(kind):
                raise LoadError("dem.py: %s has %d bytes in dem.h and %d in dem.py; make dem.py again: python3 make.py"
                                  % (kind.c_name, size, ctypes.sizeof(kind)))
    if hasattr(library, "dempy_progress"):
        ctypes.c_void_p.in_dll(library, "dempy_progress").value = ctypes.cast(_trials_stopped, ctypes.c_void_p).value
    world = library.dem_world_create_checked(WorldDesc(), VERSION, ctypes.sizeof(Real))
    if not world:
        raise LoadError("dem.py: %s is of another version than %d.%d.%d, or not in %s precision; build it from the "
                          "dem.h that belongs to dem.py" % (path, VERSION_MAJOR, VERSION_MINOR, VERSION_PATCH,
                                                            "single" if Real is ctypes.c_float else "double"))
    library.dem_world_destroy(world)
    _lib.__dict__["path"] = path


# ---- values: Python objects to C and back -------------------------------------------------------

class View:
    """The kind of a pointer to `kind`, with the names of the fields that hold the lengths of its axes; "_per_body": the
    numbers on bodies. one: it points to one struct, not to an array. times: there are so many pointers."""

    def __init__(self, kind, *shape, const=False, one=False, times=0):
        self.kind, self.shape, self.const, self.one, self.times = kind, shape, const, one, times
        self.c = ctypes.POINTER(kind)*times if times else ctypes.POINTER(kind)
        self.width = shape[1] if len(shape) > 1 and isinstance(shape[1], int) else 1


class Text:
    """The kind of an array of characters."""

    def __init__(self, size):
        self.c = ctypes.c_char*size


class _Known:
    """The kind of a number of contacts, which is -1 while the contacts are not known."""

    def __init__(self, kind):
        self.c = kind


class Choices:
    """The kind of an array of numbers of an enum."""

    def __init__(self, kind, size):
        self.kind, self.size, self.c = kind, size, ctypes.c_int*size


class Function:
    """The kind of a function that you pass in. wrap: makes a C function of a Python function."""

    def __init__(self, wrap, result, *arguments):
        self.wrap, self.result, self.arguments = wrap, result, arguments
        self.c = ctypes.CFUNCTYPE(result, *arguments)


_LIMITS = {kind: (-2**(8*ctypes.sizeof(kind) - 1) if signed else 0, 2**(8*ctypes.sizeof(kind) - signed) - 1) for kinds, signed in (
    ((ctypes.c_int8, ctypes.c_int16, ctypes.c_int32, ctypes.c_int64, ctypes.c_int, ctypes.c_long, ctypes.c_longlong), 1),
    ((ctypes.c_uint8, ctypes.c_uint16, ctypes.c_uint32, ctypes.c_uint64, ctypes.c_uint, ctypes.c_ulong, ctypes.c_size_t), 0))
    for kind in kinds}
_NUMBERS = {ctypes.c_float, ctypes.c_double, *_LIMITS}
_set = ctypes.Structure.__setattr__
_WORDS = {"groups", "body_reals", "law_memory_names", "columns"}    # texts that are lists of names


def _given(value):
    """A value that is refused, as error messages show it."""
    if value is None:
        return "None is given"
    kind, shape = type(value).__name__, getattr(value, "shape", None)
    if isinstance(shape, tuple):
        return "a %s of shape %s is given" % (kind, shape)
    try:
        text = repr(value.name.lower() if isinstance(value, enum.IntEnum) else value)
    except Exception:
        text = "<%s>" % kind
    return "%s (%s) is given" % (text if len(text) <= 60 else text[:57] + "...", kind)


def _named(error, where):
    """The exception of this library for a wrong value: `where` says which call and which argument or field."""
    kind = (type(error) if isinstance(error, Error) else ArgumentTypeError if isinstance(error, TypeError) else
            ArgumentRangeError if isinstance(error, OverflowError) else ArgumentError)
    return kind("%s: %s" % (where, error))


def _number(value, kind):
    """value as a number of an enum (which may be given by name) or of a C type. A text, a float in the place of a whole
    number and a bool in the place of a real raise TypeError; a number that does not fit raises OverflowError."""
    if kind is ctypes.c_double and type(value) is float:
        return value
    names = isinstance(kind, type) and issubclass(kind, enum.IntEnum)
    if names and isinstance(value, str):
        try:
            return kind[value.upper()]
        except KeyError:
            raise ValueError("%s has no %r; it has %s" % (kind.__name__, value, ", ".join(
                member.name.lower() for member in kind))) from None
    if isinstance(value, ctypes._SimpleCData):
        value = value.value
    if names or kind in _LIMITS:
        try:
            whole = operator.index(None if names and isinstance(value, bool) else value)
        except TypeError:
            raise TypeError("%s, %s is wanted" % (_given(value), "a word or a number of %s" % kind.__name__ if names
                                                  else "a whole number")) from None
        low, high = _LIMITS[ctypes.c_int if names else kind]
        if not low <= whole <= high:
            raise OverflowError("%d is given, must be from %d to %d" % (whole, low, high))
        if names and whole not in kind._value2member_map_:
            raise ValueError("%s has no %d; it has %s" % (kind.__name__, whole, ", ".join(
                "%d (%s)" % (member, member.name.lower()) for member in kind)))
        return whole
    if kind in _NUMBERS:
        if isinstance(value, (str, bytes, bytearray, bool)) or not (hasattr(value, "__float__") or hasattr(value, "__index__")):
            raise TypeError("%s, a number is wanted" % _given(value))
        try:
            real = float(value)
        except (TypeError, ValueError):             # an array of several numbers
            raise TypeError("%s, a number is wanted" % _given(value)) from None
        if kind is ctypes.c_float and math.isinf(kind(real).value) and not math.isinf(real):
            raise OverflowError("%r does not fit into single precision" % (value,))
        return real
    return value


def _pointer(value):
    """value as an untyped pointer."""
    if value is None:
        return None
    if isinstance(value, (ctypes.Array, ctypes.Structure, ctypes._CFuncPtr)):
        return ctypes.addressof(value)
    if isinstance(value, (ctypes._Pointer, ctypes.c_void_p)):
        return ctypes.cast(value, ctypes.c_void_p).value
    if isinstance(value, int) and not isinstance(value, bool) and 0 <= value < 2**(8*ctypes.sizeof(ctypes.c_void_p)):
        return value
    raise TypeError("%s, a pointer or None is wanted" % _given(value))


def _chars(value, null=True):
    """value as the bytes of a C text."""
    if isinstance(value, (str, os.PathLike)):
        value = os.fsencode(value)
    if value is None and null:
        return None
    if not isinstance(value, bytes):
        raise TypeError("%s, a text is wanted" % _given(value))
    if b"\0" in value:
        raise ValueError("%s, a text without the character 0 is wanted" % _given(value))
    return value


def _renamed(function, wrong, right):
    """What a function returns. Its error messages begin with the name of the call that uses it."""
    try:
        return function()
    except Error as error:
        if str(error).startswith(wrong + ":"):
            raise type(error)(right + str(error)[len(wrong):]) from None
        raise


def _wanted(value, kind):
    """What was given instead of an object of this kind."""
    hint = "; write world.group(%r)" % value if isinstance(value, str) and kind.__name__ == "Group" else ""
    return "%s, a %s is wanted%s" % (_given(value), kind.__name__, hint)


def _text_of(value, where):
    """value as the bytes of a C text; None is refused."""
    try:
        return _chars(value, False)
    except (TypeError, ValueError) as error:
        raise _named(error, where) from None


def _data_of(value, where):
    """value as bytes: of a text, or of a buffer."""
    try:
        return value.encode() if isinstance(value, str) else bytes(memoryview(value.view if isinstance(value, Array) else value))
    except TypeError:
        raise ArgumentTypeError("%s: %s, a text or bytes are wanted" % (where, _given(value))) from None


def _enum_of(value, kind, where):
    try:
        return _number(value, kind)
    except (TypeError, ValueError, OverflowError) as error:
        raise _named(error, where) from None


def _struct_of(kind, value, where):
    """value as a struct of this kind: None is refused."""
    if value is None:
        raise ArgumentTypeError("%s: None is given, a %s is wanted" % (where, kind.__name__))
    if kind is Selection and (isinstance(value, (Rows, Id)) or isinstance(value, (list, tuple)) and value and isinstance(value[0], Id)):
        raise ArgumentTypeError("%s: %s, a Selection is wanted: dem.Selection(bodies=[...])" % (where, _given(value)))
    if kind is Grains and not isinstance(value, (Grains, dict)):
        raise ArgumentTypeError("%s: %s, a Grains is wanted: of world.grains_read(path) or dem.Grains(positions=..., radii=...); "
                                "world.spheres adds spheres of arrays" % (where, _given(value)))
    try:
        return kind._made(value)
    except (TypeError, ValueError, OverflowError) as error:
        raise _named(error, where) from None


def _parts_of(value, world, where):
    """Wall parts with their functions bound."""
    try:
        parts = [WallPart._made(item) for item in _items(value, "a list of WallPart")]
    except (TypeError, ValueError, OverflowError) as error:
        raise _named(error, where) from None
    return [world._bound(part) for part in parts]


def _handle_of(value, kind, where):
    """The pointer of a world that is an argument."""
    if not isinstance(value, kind):
        raise ArgumentTypeError("%s: %s" % (where, _wanted(value, kind)))
    return value._c


def _size_of(count, where):
    """The length of an array that a call fills."""
    try:
        count = _number(count, ctypes.c_int)
    except (TypeError, OverflowError) as error:
        raise _named(error, where) from None
    if count > 2**28:
        raise ArgumentRangeError("%s: %d is given, must be at most %d" % (where, count, 2**28))
    return max(count, 1)


def _converter(kind, null):
    """A function that takes an argument of a call to its C type, or None if ctypes takes it as it is."""
    if kind is ctypes.c_double:
        return lambda value: value if type(value) is float else _number(value, kind)
    if kind in _LIMITS:
        low, high = _LIMITS[kind]
        return lambda value: value if type(value) is int and low <= value <= high else _number(value, kind)
    if kind in _NUMBERS:
        return lambda value: _number(value, kind)
    if isinstance(kind, type) and issubclass(kind, Id):
        def convert(value):
            if type(value) is kind:
                return value
            if value is None and null:
                return kind()
            raise TypeError(_wanted(value, kind))
        return convert
    if isinstance(kind, type) and issubclass(kind, Struct):
        def convert(value):
            if value is None and not null and kind.__name__ not in ("Quat", "Box"):
                raise TypeError("None is given, a %s is wanted" % kind.__name__)
            return kind._made(value)
        return convert
    return None


_PROOFS = []                    # what makes the built-in laws check again that the normal law has set what they read


def _law_checked(entry, name, needs):
    """A built-in law, with its arguments checked. needs: numbers of contact history, and vectors among them."""
    numbers, vectors = needs
    passed = object if numbers else type(None)              # the type of a contact history that has passed

    def check(c, memory, f):
        nonlocal passed
        if type(c) is not Contact and type(c) is not _read(Contact) or type(f) is not ContactForce:
            wrong, kind = (f, ContactForce) if type(c) in (Contact, _read(Contact)) else (c, Contact)
            raise ArgumentTypeError("%s: %s: %s, a %s is wanted" % (name, "c" if kind is Contact else "f", _given(wrong), kind.__name__))
        if numbers or memory is not None:
            if not isinstance(memory, ctypes.Array) or memory._type_ is not Real:
                raise ArgumentTypeError("%s: memory: %s, the contact history that the law receives is wanted" % (name, _given(memory)))
            if len(memory) < numbers:
                raise ArgumentError(
                    "%s: memory: this law needs %d number%s of contact history, %d %s here; make the world with law_memory=%d or "
                    "more%s" % (name, numbers, "s"*(numbers > 1), len(memory), "is" if len(memory) == 1 else "are", numbers,
                                " and law_vectors=1 or more" if vectors else ""))
            if vectors and getattr(memory, "vectors", 1) < vectors:
                raise ArgumentError("%s: memory: the first three numbers of its contact history are a vector, which law_vectors "
                                    "does not count; make the world with law_vectors=1 or more, and give vectors the first places"
                                    % name)
            passed = type(memory)

    fields = _LAW_READS.get(name[4:], ())
    proved = not fields
    stiff = [field for field in fields if field not in ("ct", "load")]
    limit = "spinning_friction" if "twist" in name else "rolling_friction" if "roll" in name else "friction"

    def prove(c, f):
        """Raises if the normal law in front of this one has set no field that this law reads; warns if it has set some."""
        nonlocal proved
        if not f.normal > 0 or not getattr(c, limit) > 0:
            return                                          # nothing is missed here
        proved = True
        lost = [field for field in stiff or ("ct",)*("ct" in fields) if not getattr(f, field)]
        if not f.load and not f.elastic:
            lost.append("load")
        if not lost:
            return
        text = ("%s: force.%s %s 0, so %s; dem.law_hertz, law_linear and law_hysteretic set force.%s; a normal law of your own sets them "
                "before it calls %s, and dem.law_load sets the load (docs/python_how_to.md)" % (
                    name, " and ".join(lost), "is" if len(lost) == 1 else "are", "it gives no force" if limit == "friction" else
                    "it gives no moment", ", ".join(fields), name))
        if stiff and lost == stiff + ["load"] and not ("ct" in fields and f.ct):
            raise ArgumentError(text)
        warnings.warn(text, stacklevel=4)

    def renew():
        nonlocal proved
        proved = not fields
    _PROOFS.append(renew)

    def call(c, memory, f):
        if type(c) is not contact or type(memory) is not passed or type(f) is not ContactForce:
            check(c, memory, f)
        if not proved:
            prove(c, f)
        entry(c, memory, f)
    contact = _read(Contact)
    return call


def _checked(entry, name, names, kinds):
    """The function `entry`, with its arguments checked, of which ctypes would take numbers modulo 2**32. name, names: of
    the call and its arguments in Python; "=" behind a name allows None."""
    if name in _LAW_NEEDS and len(kinds) == 3:
        return _law_checked(entry, "dem." + name, _LAW_NEEDS[name])
    places = [(i, _converter(kind, names[i].endswith("="))) for i, kind in enumerate(kinds) if names[i] != "self"]
    places = [place for place in places if place[1]]
    ids = [i for i, kind in enumerate(kinds) if isinstance(kind, type) and issubclass(kind, Id) and names[i] != "self"]
    structs = [(i, kind._type_) for i, kind in enumerate(kinds) if isinstance(kind, type) and issubclass(kind, ctypes._Pointer)
               and issubclass(kind._type_, Struct) and "." not in name and name != "World"]
    if not places and not structs:
        return entry
    where = name if "." in name or name == "World" else "dem." + name

    def call(*values):
        values, i = list(values), 0
        try:
            for i, convert in places:
                values[i] = convert(values[i])
        except (TypeError, ValueError, OverflowError) as error:
            raise _named(error, "%s: %s" % (where, names[i].rstrip("="))) from None
        for i in ids:
            of = values[i]._of
            if of is not None and of._at != values[0]:
                raise ArgumentError("%s: %s: %r belongs to another world%s" % (where, names[i].rstrip("="), values[i],
                                                                              "" if of._at else ", which is closed"))
        for i, kind in structs:
            if not isinstance(values[i], kind):
                raise ArgumentTypeError("%s: %s: %s" % (where, names[i].rstrip("="), _wanted(values[i], kind)))
        return entry(*values)
    call.entry = entry                                      # the function of the library itself
    return call


def _near(name, names):
    """What a misspelled name may have meant, as the end of an error message."""
    import difflib

    names = list(names)
    found = difflib.get_close_matches(str(name), names, 3) or [one for one in names if len(str(name)) > 2 and str(name) in one][:3]
    if found:
        return "; did you mean %s?" % " or ".join(found)
    return "; it has %s" % ", ".join(names) if names else "; it has none"


def _unbound(function, where, values, fields):
    """The exception for arguments that do not fit the parameters of a function; None if they fit."""
    import inspect

    all_of = [p for p in inspect.signature(function).parameters.values() if p.name not in ("self", "cls")]
    if any(p.kind is p.VAR_POSITIONAL for p in all_of):     # a constructor of a struct, which checks them itself
        return None
    plain = [p.name for p in all_of if p.kind is p.POSITIONAL_OR_KEYWORD]
    named = [p.name for p in all_of if p.kind is p.KEYWORD_ONLY]
    for name in fields:
        if name not in plain + named:
            return ArgumentTypeError("%s: there is no argument %r%s" % (where, name, _near(name, plain + named)))
    if len(values) > len(plain):
        if named:
            some = ", ".join("%s=..." % name for name in named[:3])
            return ArgumentTypeError("%s: %s %s given without a name; %s: %s(%s)" % (
                where, ", ".join(map(_short, values[len(plain):])), "is" if len(values) == len(plain) + 1 else "are", "these arguments must have names" if plain == [] else
                "arguments behind %s must have names" % plain[-1], where, ", ".join(plain + [some] + ["..."]*(len(named) > 3))))
        return ArgumentTypeError("%s: %d argument%s given, %s; %s(%s)" % (
            where, len(values), " is" if len(values) == 1 else "s are", "it takes %s%d" % ("at most " if any(p.default is not p.empty for p in all_of) else "", len(plain))
            if plain else "it takes none", where, ", ".join(plain)))
    twice = [name for name in plain[:len(values)] if name in fields]
    if twice:
        return ArgumentTypeError("%s: %s is given twice" % (where, twice[0]))
    lost = [p.name for p in all_of if p.default is p.empty and p.name not in fields and p.name not in plain[:len(values)]]
    if lost:
        return ArgumentTypeError("%s: %s %s missing; %s(%s)" % (where, ", ".join(lost), "is" if len(lost) == 1 else "are", where,
                                                               ", ".join(plain + ["%s=..." % name for name in named if name in lost])))
    return None


def _short(value):
    """A value as an error message shows it, without its type."""
    text = _given(value)
    return text[:text.rindex(" (")] if text.endswith(" is given") and " (" in text else text.replace(" is given", "")


def _on_class(where, values):
    """The exception for a method that is called on its class, without an object."""
    name, _, call = where.partition(".")
    return ArgumentTypeError("%s: %s in the place of the %s that this call needs; write %s.%s(...), not dem.%s(...)" % (
        where, _given(values[0]) if values else "nothing is given", name,
        {"Rows": "world.bodies"}.get(name, name.lower()), call, where))


def _binds(function, where, own, kind=None):
    """A function whose arguments that do not fit raise ArgumentTypeError. own: the first is self; kind: its class."""
    @functools.wraps(function)
    def bind(*values, **fields):
        try:
            return function(*values, **fields)
        except Exception as error:
            if kind and not (values and isinstance(values[0], kind)):
                raise _on_class(where, values) from None
            if not isinstance(error, TypeError) or error.__traceback__.tb_next is not None:
                raise                                       # of the function, not of its call
            name, dot, call = where.partition(".")
            if own and dot and isinstance(values[0], (type, Handle, Struct, Rows)):
                name = (values[0] if isinstance(values[0], type) else type(values[0])).__name__
            found = _unbound(function, name + dot + call, values[own:], fields)
        raise found or ArgumentTypeError("%s: the arguments do not fit" % where)
    return bind


def _binds_law(function, name):
    """The same for a built-in law, without a call in between: laws in Python call them for each contact."""
    library, key = _lib.__dict__, "dempy_" + name

    @functools.wraps(function)
    def bind(*values, **fields):
        try:
            return library[key](*values, **fields)
        except TypeError:
            found = _unbound(function, "dem." + name, values, fields)
            if not found:
                raise
        except KeyError:                                    # the library is not loaded yet
            return function(*values, **fields)
        raise found
    return bind


def _bind_all(names):
    """Gives the public functions and methods of the module the error messages of _binds."""
    for name, thing in list(names.items()):
        if getattr(thing, "__module__", "") != __name__ or name[0] == "_" or name != getattr(thing, "__name__", name):
            continue
        if isinstance(thing, types.FunctionType):
            names[name] = _binds_law(thing, name) if name in _LAW_NEEDS else _binds(thing, "dem." + name, 0)
        elif isinstance(thing, type):
            for part, member in list(vars(thing).items()):
                if isinstance(member, types.FunctionType) and (part[0] != "_" or part == "__init__" and not issubclass(
                        thing, (Struct, ReplayBase, SlabsBase))):
                    where = thing.__name__.replace("Base", "")
                    where = {"Handle": "World", "Numbers": "Vec3", "Vector": "Vec3"}.get(where, where)
                    where += ".%s" % part if part != "__init__" else ""
                    setattr(thing, part, _binds(member, where, 1, thing))
                elif isinstance(member, classmethod) and part[0] != "_" and part != "from_param":
                    setattr(thing, part, classmethod(_binds(member.__func__, "%s.%s" % (thing.__name__, part), 1)))


def _c(kind):
    return ctypes.c_int if isinstance(kind, type) and issubclass(kind, enum.IntEnum) else getattr(kind, "c", kind)


def _listed(value):
    """value.tolist(), also of a memoryview of ctypes, in whose format the byte order is written, which tolist refuses."""
    try:
        return value.tolist()
    except NotImplementedError:
        view = memoryview(value)
        if view.format[:-1] != "<>"[sys.byteorder == "big"]:
            raise TypeError("%s, numbers are wanted" % _given(value)) from None
        return view.cast("B").cast(view.format[-1], view.shape).tolist() if view.nbytes else []


def _items(value, wanted):
    """The elements of a sequence."""
    if isinstance(value, (str, bytes, bytearray, dict, set, frozenset)):
        raise TypeError("%s, %s is wanted" % (_given(value), wanted))
    if hasattr(value, "__array__") and not hasattr(value, "tolist") and not isinstance(value, type):
        value = value.__array__()                           # a table of pandas
    if hasattr(value, "tolist"):
        value = _listed(value)
    try:
        return list(value)
    except TypeError:
        raise TypeError("%s, %s is wanted" % (_given(value), wanted)) from None


def _convert(value, kind, exact=True):
    """value as the kind of a field that is not an array behind a pointer: sequences become structs and arrays."""
    kind = kind.c if isinstance(kind, _Known) else kind
    if kind in _NUMBERS:
        return _number(value, kind)
    if isinstance(kind, Text) or kind is str:
        return _chars(value)
    if isinstance(kind, type) and issubclass(kind, Struct):
        return kind._made(value)
    if isinstance(kind, Choices):
        if isinstance(value, str):
            raise TypeError("%s, %d words are wanted, one for each axis" % (_given(value), kind.size))
        items = _items(value, "%d words" % kind.size)
        if items and len(items) != kind.size:
            raise ValueError("%d words are given, %d are wanted, one for each axis" % (len(items), kind.size))
        return kind.c(*[_number(item, kind.kind) for item in items])
    if isinstance(kind, type) and issubclass(kind, ctypes.Array):
        if isinstance(value, (kind, kind._type_*kind._length_)):
            return value
        if value is None:
            return kind()
        if isinstance(value, Struct) and not (issubclass(kind._type_, Struct) and isinstance(value, kind._type_)):
            value = tuple(value)
        if exact or _many(value):
            items = _items(value, "a sequence of %d numbers" % kind._length_)
        else:
            items = [value]                                 # one class
        if len(items) > kind._length_ or exact and items and len(items) != kind._length_:
            raise ValueError("%d values are given, %s%d are wanted" % (len(items), "" if exact else "at most ", kind._length_))
        return kind(*[_item(item, kind._type_) for item in items])
    if kind is ctypes.c_void_p:
        return _pointer(value)
    if isinstance(kind, type) and issubclass(kind, enum.IntEnum):
        return _number(value, kind)
    if isinstance(kind, type) and issubclass(kind, ctypes._Pointer):
        if value is None:
            return kind()
        if not isinstance(value, kind) and not (isinstance(value, ctypes.Array) and value._type_ is kind._type_):
            raise TypeError("%s, a pointer or None is wanted" % _given(value))
        return ctypes.cast(value, kind)
    return value


def _many(value):
    """True of what has several elements."""
    return hasattr(value, "__len__") and not isinstance(value, (Struct, type))


def _item(value, kind):
    """An element of an array: a struct, a pointer to one, or a number."""
    if issubclass(kind, Struct):
        return kind._made(value)
    if issubclass(kind, ctypes._Pointer):
        if value is not None and issubclass(kind._type_, Struct):
            return ctypes.pointer(kind._type_._made(value))
        return _convert(value, kind)
    return _number(value, kind)


def _array(value, kind, width=1, count=None, null=False):
    """value as a C array of `kind`: the memory of a buffer of that kind itself, otherwise a copy. Nested sequences are
    flattened; their last axis must have the length `width`. count: the number of rows that is required."""
    rows = "N" if count is None else count
    wanted = "(%s,)" % rows if width == 1 else "(%s, %d)" % (rows, width)
    if value is None:
        if null:
            return None
        raise TypeError("None is given, an array of shape %s is wanted" % wanted)
    if isinstance(value, ctypes.Array) and value._type_ is kind:
        array = value
    elif issubclass(kind, Struct):
        array = [kind._made(item) for item in _items(value, "a list of %s" % kind.__name__)]
        array = (kind*len(array))(*array)
    else:
        array = _reals(value, kind, width, wanted, count)
    if len(array) % width:
        raise ValueError("%d numbers are given, which is no multiple of %d; an array of shape %s is wanted" % (len(array), width, wanted))
    if count is not None and len(array) != count*width:
        n = len(array)//width
        raise ValueError("the shape %s is given, %s is wanted" % ("(%d,)" % n if width == 1 else "(%d, %d)" % (n, width), wanted))
    return array


def _remedy(shape, width, count):
    """What makes an array of this shape fit, as the end of an error message."""
    if width == 3 and shape[-1] == 4:                       # what world.bodies.positions returns
        return "; leave out column 4: array[:, :3]"
    if len(shape) == 2 and shape[0] == width and count in (None, shape[1]):
        return "; transpose it"
    return ""


def _reals(value, kind, width, wanted, count):
    """Numbers as a C array."""
    if isinstance(value, (str, bytes, bytearray, dict, set, frozenset)):
        raise TypeError("%s, an array of shape %s is wanted" % (_given(value), wanted))
    if isinstance(value, Array):
        value = value.view
    try:
        view = memoryview(value)
    except (TypeError, ValueError):
        view = None
        if hasattr(value, "__array__") and not isinstance(value, type):     # a table of pandas
            value = value.__array__()
    shape = view.shape if view else getattr(value, "shape", None)
    if isinstance(shape, tuple):
        if not shape:
            raise TypeError("%s, an array of shape %s is wanted" % (_given(value), wanted))
        if len(shape) > 1 and shape[-1] != width and not (0 in shape):
            raise ValueError("the shape %s is given, %s is wanted%s" % (
                shape, wanted, _remedy(shape, width, count)))
    if view and view.c_contiguous and not view.readonly and view.format.lstrip("<@=") == kind._type_:
        return (kind*(view.nbytes//ctypes.sizeof(kind))).from_buffer(view.cast("B"))
    if hasattr(value, "tolist"):
        value = _listed(value)
    numbers = []
    _rows(value, numbers, kind, width, wanted, 0)
    return (kind*len(numbers))(*numbers)


def _rows(value, numbers, kind, width, wanted, depth):
    """Appends the numbers of a nested sequence. A row that has not the length `width` is refused."""
    try:
        items = iter(value)
    except TypeError:
        raise TypeError("%s, an array of shape %s is wanted" % (_given(value), wanted)) from None
    begun, nested = len(numbers), False
    for item in items:
        if type(item) is float or type(item) is int and kind in _LIMITS or not hasattr(item, "__iter__") or isinstance(item, (str, bytes)):
            numbers.append(_number(item, kind))
            continue
        if hasattr(item, "tolist"):
            item = _listed(item)
            if not hasattr(item, "__iter__"):
                numbers.append(_number(item, kind))
                continue
        if isinstance(item, (dict, set, frozenset)) or depth > 3:
            raise TypeError("%s, an array of shape %s is wanted" % (_given(item), wanted))
        if not nested and len(numbers) > begun:
            raise ValueError("numbers and rows are mixed, an array of shape %s is wanted" % wanted)
        nested = True
        _rows(item, numbers, kind, width, wanted, depth + 1)
    found = len(numbers) - begun
    if depth and not nested and found != width:
        raise ValueError("row %d has the shape (%d,), an array of shape %s is wanted%s" % (
            begun//width, found, wanted, "; leave out number 4 of each row" if width == 3 and found == 4 else ""))


def _one_radius(radii, radius, where):
    """Refuses a radius of all beside the radius of each."""
    if radii is not None and radius is not None and not (isinstance(radius, (int, float)) and radius == 0):
        raise ArgumentError("%sradii and radius are given, one of them is wanted: radii for each, or radius for all" % where)


def _array_of(value, kind, where, width=1, count=None, null=False):
    """An array that is an argument of a call."""
    if count == 0 and ".reals_set" in where or width == 0:
        raise ArgumentError("%s: this world has no numbers on bodies; name them when you make it: dem.World(body_reals=\"...\")" % where)
    try:
        return _array(value, kind, width, count, null)
    except (TypeError, ValueError, OverflowError) as error:
        raise _named(error, where) from None


def _view(pointer, kind, shape, owner, const, name):
    """The memory behind a pointer as a memoryview of this shape (of structs: as a C array); None for
    null, and of numbers also if there are none."""
    if not pointer:
        return None
    count = 1
    for length in shape:
        count *= length
    if issubclass(kind, Struct):
        array = _row(kind, count).from_address(ctypes.addressof(pointer.contents)) if count else _row(kind, 0)()
        array.owner, array._call = owner, owner._call
        return array
    if not count:
        return None
    array = (kind*count).from_address(ctypes.addressof(pointer.contents))
    array.owner = owner                                     # the world lives as long as the view
    view = memoryview(array).cast("B").cast(array._type_._type_, list(shape))
    return Array(view.toreadonly() if const else view, name)


class Array:
    """Numbers with one or two axes: a view of memory of the world, or a copy. len, indices and loops go by rows; array[i, j],
    array[i], array[1:3], array[:, 2] and array[:, :3] are parts of it. numpy.asarray(array) views it, array.tolist() is a
    list, array.view the memoryview."""
    __slots__ = ("view", "_name")

    def __init__(self, view, name="positions"):
        self.view = view if isinstance(view, memoryview) else memoryview(view)
        self._name = name                                   # of the field, for error messages

    def __getattr__(self, name):                            # shape, tolist, nbytes, ...
        if name[:2] == "__":
            raise AttributeError(name)
        if name[0] != "_" and hasattr(memoryview, name):
            return getattr(self.view, name)
        raise NoFieldError("Array has no attribute %r; it has shape, tolist() and those of a memoryview; numpy.asarray(array) "
                           "has more" % name)

    @property
    def shape(self):
        """The lengths of the axes."""
        return self.view.shape

    def tolist(self):
        """The numbers as a list, of lists if there are two axes."""
        return self.view.tolist()

    def tobytes(self):
        """The numbers as bytes."""
        return self.view.tobytes()

    def __len__(self):
        return len(self.view)

    def _flat(self):
        view = self.view
        return view if view.ndim == 1 else view.cast("B").cast(view.format)

    def __getitem__(self, index):
        view = self.view
        try:
            if view.ndim == 1:
                found = view[index[0] if type(index) is tuple and len(index) == 1 else index]
                return Array(found) if type(found) is memoryview else found
            if type(index) is tuple and len(index) == 2 and slice not in (type(index[0]), type(index[1])):
                return view[index]
            return self._part(*index if type(index) is tuple else (index,))
        except TypeError:
            raise ArgumentTypeError("array[...]: %s, numbers or slices are wanted, one for each of %d axes" % (
                _given(index), view.ndim)) from None
        except (IndexError, ValueError, NotImplementedError):
            raise NoSuchError("array[...]: %s, the array has the shape %s" % (_given(index), view.shape)) from None

    def _part(self, i, j=slice(None)):
        """Rows, or a part of rows, or of columns, of an array with two axes."""
        view, flat = self.view, self._flat()
        count, width = view.shape
        rows, columns = range(count)[i], range(width)[j]
        if isinstance(rows, int):
            return Array(flat[width*rows:width*rows + width][j])
        if isinstance(columns, int):
            return Array(flat[columns::width][i])
        if rows.step == 1 and len(columns) == width and columns.step == 1 and len(rows):
            return Array(flat[width*rows.start:width*rows.stop].cast("B").cast(view.format, [len(rows), width]))
        part = memoryview(bytearray(len(rows)*len(columns)*view.itemsize)).cast(view.format)     # a copy
        for k, row in enumerate(rows):
            part[k*len(columns):(k + 1)*len(columns)] = flat[width*row:width*row + width][j]
        return Array((part.cast("B").cast(view.format, [len(rows), len(columns)]) if len(part) else part).toreadonly())

    def __setitem__(self, index, value):
        view = self.view
        if view.readonly:
            raise ArgumentTypeError("array[...]: this array is read-only; numpy.array(array) is a copy that you may change; %s" % (
                "world.bodies.%s = array sets all rows" % self._name if self._name in ("positions", "velocities", "spins") else
                _SETTERS.get(self._name) or "dem.h computes the %s" % self._name))
        part = self[index]
        try:
            if not isinstance(part, Array):
                view[index] = value
                return
            items, target = _items(value, "%d numbers" % len(part)), part.view
            if target.ndim != 1 or target.readonly or len(items) != len(target):
                raise ValueError("%s; one number or one row can be set" % _given(value))
            for i, item in enumerate(items):
                target[i] = item
        except (TypeError, ValueError) as error:
            raise _named(error, "array[%s]" % (index,)) from None

    def _no_sums(self, other):
        """Arithmetic, which is that of numpy. An array of numpy on the other side answers itself."""
        if hasattr(other, "__array__") and not isinstance(other, (Array, Struct)):
            return NotImplemented
        raise ArgumentTypeError("Array has no arithmetic; write numpy.asarray(a) - ..., numpy.asarray(a)*2 and so on")

    __add__ = __radd__ = __sub__ = __rsub__ = __mul__ = __rmul__ = __truediv__ = __rtruediv__ = __pow__ = _no_sums

    def __neg__(self):
        return self._no_sums(0)

    def __iter__(self):
        view = self.view
        if view.ndim == 1:
            return iter(view)
        flat, width = self._flat(), view.shape[1]
        return (Array(flat[k:k + width]) for k in range(0, len(flat), width))

    def __eq__(self, other):
        if isinstance(other, (Array, memoryview)):
            return self.view == getattr(other, "view", other)
        return self.tolist() == _plain(list(other)) if isinstance(other, (list, tuple)) else NotImplemented

    __hash__ = None

    def __repr__(self):
        rows = [repr(row) for row in (self.view[:4].tolist() if self.view.ndim == 1 else [row.tolist() for row in self[:4]])]
        return "Array([%s%s])" % (", ".join(rows), ", ... (%s)" % " x ".join(map(str, self.view.shape)) if len(self) > 4 else "")

    @property
    def __array_interface__(self):                          # numpy looks here first
        view = self.view
        if not view.c_contiguous:
            raise AttributeError("__array_interface__")
        return {"shape": view.shape, "typestr": _TYPESTRS[view.format], "data": view, "version": 3}

    def __array__(self, dtype=None, copy=None):
        import numpy
        array = numpy.asarray(self.view)
        if dtype is not None and dtype != array.dtype:
            return array.astype(dtype)
        return array.copy() if copy else array

    def __buffer__(self, flags):
        return memoryview(self.view)

    def __reduce_ex__(self, _):
        return _array_from, (self.view.format, self.view.shape, self.view.tobytes())


_TYPESTRS = {kind._type_: "%s%s%d" % ("<" if sys.byteorder == "little" else ">", "f" if kind not in _LIMITS else "i" if _LIMITS[
    kind][0] else "u", ctypes.sizeof(kind)) for kind in _NUMBERS}


def _array_from(form, shape, data):
    """An array that was pickled."""
    view = memoryview(data).cast(form)
    return Array(view.cast("B").cast(form, shape) if len(shape) > 1 and len(view) else view)


def _plain(value):
    """A value as Python's own kinds: structs become dicts, arrays lists."""
    if isinstance(value, (Vec3, Quat)):
        return tuple(value)
    if isinstance(value, Struct):
        return value.to_dict()
    if isinstance(value, (memoryview, Array)):
        return value.tolist()
    if isinstance(value, (ctypes.Array, list, tuple)):
        return [_plain(item) for item in value]
    return value


def _array_bytes(field, kind, struct):
    """The bytes of an array behind a pointer; None of null."""
    pointer = getattr(struct, "_" + field)
    if kind.times or not pointer:
        return None
    if kind.one:
        return [pointer[0]]
    count = kind.width*next((getattr(struct, length) for length, arrays in struct.counts.items()
                             if field in [array for array, _ in arrays]), 0)
    if issubclass(kind.kind, Struct):
        return [pointer[i] for i in range(count)]
    return ctypes.string_at(pointer, count*ctypes.sizeof(kind.kind))


def _struct_from(kind, data, arrays, functions, raw):
    """A struct that was pickled."""
    struct = kind.from_buffer_copy(data)
    for name, value in arrays.items():
        item = kind.kinds[name].kind
        if isinstance(value, list):
            array = (item*len(value))(*value)
        else:
            array = (item*(len(value)//ctypes.sizeof(item))).from_buffer_copy(value)
        _set(struct, "_" + name, ctypes.cast(array, kind.kinds[name].c))
        struct.__dict__.setdefault("_extra", []).append(array)
    for name, value in raw.items():
        _set(struct, name, value)
    if functions:
        struct.__dict__["_functions"] = functions
    return struct


class Struct(ctypes.Structure):
    """A struct of dem.h. Fields are keyword arguments; fields that are not given are 0."""
    rows, c_name, counts, kinds, counted, lengths, numbers = [], "", {}, {}, (), {}, False
    # _functions: Python functions, by their path; _of: the world; _extra: what must live as long; _ids: ids that it holds;
    # _call: the call that changes what this copy shows; _per_body: how many numbers on bodies its pointers show
    _functions = _of = _extra = _ids = _call = None
    _per_body = 0

    def __getattr__(self, name):
        raise _no_attribute(self, name)

    def __init__(self, *values, **fields):
        if len(values) > len(self.rows) or values and self.numbers and len(values) < len(self.rows):
            raise ArgumentTypeError("%s: %d values are given, %s%d are wanted (%s)" % (
                type(self).__name__, len(values), "" if self.numbers else "at most ", len(self.rows), ", ".join(self.kinds)))
        if values and self.numbers and not fields:
            super().__init__(*values)
            return
        super().__init__()
        if values or fields:
            both = set(fields).intersection(list(self.kinds)[:len(values)])
            if both:
                raise ArgumentTypeError("%s: %s is given twice" % (type(self).__name__, both.pop()))
            self._put(dict(zip(self.kinds, values), **fields))

    @classmethod
    def _of_call(cls, where, fields):
        """A struct of the arguments of a call, whose name error messages have."""
        made = cls()
        made._put(fields, where + ": ")
        try:
            made._fit()
        except ArgumentError as error:
            raise _named(error, where) from None
        for name in cls.needs.get(made.kind.name.lower(), ()) if "kind" in fields else ():
            if all(made._is_zero(one) for one in name.split()):
                warnings.warn("%s: a wall of kind %r without %s does not move or bears nothing" % (
                    where, made.kind.name.lower(), " or ".join("%s=..." % one for one in name.split())), stacklevel=4)
        return made

    def _is_zero(self, name):
        """True of a field that is 0, or has the value that 0 means."""
        value = getattr(self, name)
        return value == getattr(type(self)(), name) or name in self.defaults and value == self.defaults[name]

    def _fit(self):
        """Refuses a field that has no use beside the others, one below 0 that must not be, and the lack of a required
        one. Returns self."""
        for name, conditions in self.uses.items():
            if not self._is_zero(name):
                for other, words in conditions:
                    self._use(name, other, words)
        for name, remedy in self.positive.items():
            if getattr(self, name) < 0:
                raise ArgumentError("%s: %s, must be >= 0; %s" % (name, _given(getattr(self, name)), remedy))
        for name in self.required:
            if self._is_zero(name):
                doc = next(doc for one, _, doc in self.rows if one == name).partition(". ")[0]
                raise ArgumentError("%s was not given, or is 0; it has no default (%s); give %s=%s" % (
                    name, doc, name, "(x0, y0, z0, x1, y1, z1)" if self.kinds[name] is Box else "..."))
        return self

    def _use(self, name, other, words):
        """Refuses a field that has no use. words: of the field `other` that have a use for it; True: `other` must be
        given; False: it must not."""
        value, zero, text = getattr(self, other), self._is_zero(other), ""
        if words is True and zero:
            text = "without %s=... it has no use; give %s=..., or leave out %s" % (other, other, name)
        elif words is False and not zero:
            text = "beside %s=... it has no use; leave out one of them" % other
        elif isinstance(words, tuple) and value.name.lower() not in words:
            text = "with %s=%r it has no use; it belongs to %s=%s" % (
                other, value.name.lower(), other, " or ".join(map(repr, words)))
        if text:
            raise ArgumentError("%s: %s, but %s" % (name, _given(getattr(self, name)), text))

    def _put(self, fields, where=None):
        where = where or type(self).__name__ + "."
        if "radii" in fields and "radius" in fields and not isinstance(self.kinds.get("radius"), View):
            _one_radius(fields["radii"], fields["radius"], where)
        for name in fields:
            if name not in self.kinds:
                raise ArgumentTypeError("%s has no field %r%s" % (type(self).__name__, name, _near(name, self.kinds)))
        sizes, pointers = {}, False
        for name, value in fields.items():
            if name in self.counts:
                continue
            kind = self.kinds[name]
            if self._ids or self._functions:                # of the value before
                self.__dict__["_ids"] = {inner: item for inner, item in (self._ids or {}).items() if inner.partition(
                    ".")[0].partition("[")[0] != name}
                self.__dict__["_functions"] = {path: item for path, item in (self._functions or {}).items() if path[0] != name}
            if type(value) is float and kind is ctypes.c_double:
                _set(self, name, value)
                continue
            if name == "cylinder" and value in ("x", "y", "z"):
                value = ord(value)                          # dem.h has the axis as a character
            if name in _WORDS and isinstance(value, (list, tuple)) and all(isinstance(word, str) for word in value):
                value = " ".join(value)
            try:
                inner = kind.kind if isinstance(kind, View) else getattr(kind, "_type_", None)
                if isinstance(inner, type) and issubclass(inner, Struct) and not getattr(kind, "one", False):
                    # several structs, whose functions are kept
                    if isinstance(value, (inner, dict)):
                        value = [value]
                    if isinstance(value, (list, tuple)):
                        value = [inner._made(item) if isinstance(item, dict) else item for item in value]
                if isinstance(kind, View):
                    if kind.times and value is not None:
                        raise TypeError("%s, but only dem.h fills this field" % _given(value))
                    if isinstance(value, ctypes._Pointer):  # nobody knows its length
                        pointers = True
                        _set(self, "_" + name, value)
                    elif value is not None and kind.one:
                        _set(self, "_" + name, ctypes.pointer(kind.kind._made(value)))
                    elif value is not None:
                        array = _array(value, kind.kind, kind.width)
                        sizes[name] = len(array)//kind.width
                        _set(self, "_" + name, ctypes.cast(array, kind.c))
                        if kind.shape == ("_per_body",):
                            self.__dict__["_per_body"] = min(self._per_body or len(array), len(array))
                    else:
                        _set(self, "_" + name, kind.c())
                elif name in self.counted:
                    array = _convert(value, kind, False)
                    size = 0 if value is None else len(value) if _many(value) else 1
                    if size:
                        sizes[name] = size
                    _set(self, name, array)
                elif isinstance(kind, (Function, Choices, Text, _Known)) or kind is str or (
                        isinstance(kind, type) and issubclass(kind, enum.IntEnum)):
                    _set(self, name, value)                 # a property
                else:
                    _set(self, name, _convert(value, kind))
            except (TypeError, ValueError, OverflowError) as error:
                raise _named(error, where + name) from None
            if isinstance(value, Struct):
                self._keep(name, value, (name,))
            elif isinstance(value, (list, tuple)):
                for i, item in enumerate(value):
                    if isinstance(item, Struct):
                        self._keep("%s[%d]" % (name, i), item, (name, i))
        for length, arrays in self.counts.items():          # a length follows from its arrays
            self._length(length, arrays, sizes, fields, pointers, where)

    def _length(self, length, arrays, sizes, fields, pointers, where):
        """Sets the length that arrays have in common."""
        given = fields.get(length)
        if given is not None:
            try:
                given = _number(given, ctypes.c_int)
            except (TypeError, OverflowError) as error:
                raise _named(error, where + length) from None
        found = [field for field, _ in arrays if field in sizes]
        if found:
            count = sizes[found[0]]
            others = {field: size for field, size in sizes.items() if field in found and size != count}
            for field, _ in arrays:                         # arrays that are there already
                if field not in fields and getattr(self, "_" + field, None) and getattr(self, length) != count:
                    others[field] = getattr(self, length)
            if others:
                field, size = others.popitem()
                raise ArgumentError("%s%s has %d element%s, %s has %d; both must have as many" % (
                    where, field, size, "s"*(size != 1), found[0], count))
            if given and given != count:
                raise ArgumentError("%s%s is %d, but %s has %d element%s; leave it out, it follows from the array" % (
                    where, length, given, found[0], count, "s"*(count != 1)))
            _set(self, length, count)
        elif pointers and given is not None:
            _set(self, length, given)
        elif given:
            if given != getattr(self, length):
                raise ArgumentError("%s%s is %d, but %s has no elements; leave it out, it follows from the array" % (
                    where, length, given, arrays[0][0]))
        elif any(field in fields for field, _ in arrays[:1]) and not pointers:
            _set(self, length, 0)

    def _keep(self, name, value, path):
        """Keeps what C does not copy with a struct: its Python functions, the worlds of its ids, how many numbers it
        has."""
        if value._per_body:
            self.__dict__["_per_body"] = value._per_body
        if value._functions:
            functions = dict(self._functions or {})
            functions.update((path + inner, function) for inner, function in value._functions.items())
            self.__dict__["_functions"] = functions
        if isinstance(value, Id):
            if value._of is not None:
                self.__dict__["_ids"] = dict(self._ids or {}, **{name: value})
        elif value._ids:
            self.__dict__["_ids"] = dict(self._ids or {}, **{"%s.%s" % (name, inner): item for inner, item in value._ids.items()})

    def __setattr__(self, name, value):
        kind = self.kinds.get(name)
        if kind is None:
            if name[:1] == "_":
                _set(self, name, value)
                return
            raise FieldError("%s has no field %r%s" % (type(self).__name__, name, _near(name, self.kinds)))
        base = self
        while base is not None:
            if getattr(base, "_call", None):
                _changed(self, "%s.%s" % (type(self).__name__, name), name)
            base = getattr(base, "_b_base_", None)
        if kind is ctypes.c_double and type(value) is float:
            _set(self, name, value)
        elif kind in _NUMBERS and name not in self.counts:
            try:
                value = _number(value, kind)
            except (TypeError, OverflowError) as error:
                raise _named(error, "%s.%s" % (type(self).__name__, name)) from None
            _set(self, name, value)
        else:
            self._put({name: value})

    def __delattr__(self, name):
        raise FieldError("%s.%s: a field cannot be deleted" % (type(self).__name__, name))

    @classmethod
    def make(cls, value):
        """This struct from an instance, a sequence, a dict, or None (zeros)."""
        return _struct_of(cls, value, cls.__name__ + ".make") if value is not None else cls()

    @classmethod
    def _made(cls, value):
        if isinstance(value, cls):
            return value._fit() if cls.uses or cls.positive or cls.required else value
        if value is None:
            return cls()
        if isinstance(value, dict):
            if not all(isinstance(name, str) for name in value):
                raise TypeError("%s, a %s is wanted" % (_given(value), cls.__name__))
            return cls(**value)._fit()
        first = cls.rows[0][1]
        nested = isinstance(first, type) and issubclass(first, Struct)
        if isinstance(value, Struct):
            if not nested:
                raise TypeError("%s, a %s is wanted" % (_given(value), cls.__name__))
            return cls(value)
        values = _items(value, "a %s, or %d numbers (%s)" % (cls.__name__, len(cls.rows), ", ".join(cls.kinds)) if cls.numbers else
                        "a %s" % cls.__name__)
        if nested and len(values) == ctypes.sizeof(cls)//ctypes.sizeof(Real) and not any(hasattr(v, "__len__") for v in values):
            size = ctypes.sizeof(first)//ctypes.sizeof(Real)
            return cls(*[values[i:i + size] for i in range(0, len(values), size)])     # a box from six numbers
        if cls.numbers and len(values) != len(cls.rows) or cls.whole and len(values) != len(cls.rows):
            raise ValueError("%d numbers are given, %d are wanted%s" % (len(values), 6 if cls.whole else len(cls.rows), "" if cls.whole else
                                                                       " (%s)" % ", ".join(cls.kinds)))
        if len(values) != len(cls.rows) and nested:
            return cls(values)
        return cls(*values)._fit() if cls.positive else cls(*values)

    @classmethod
    def from_param(cls, value):
        return cls._made(value)

    def __iter__(self):
        return (getattr(self, name, None) for name in self.kinds)

    def __len__(self):
        return len(self.rows)

    def __getitem__(self, index):
        if isinstance(index, str):
            if index not in self.kinds:
                raise ArgumentError("%s has no field %r%s" % (type(self).__name__, index, _near(index, self.kinds)))
            return getattr(self, index)
        try:
            return tuple(self)[index]
        except TypeError:
            raise ArgumentTypeError("%s[...]: %s, the number or the name of a field is wanted" % (
                type(self).__name__, _given(index))) from None
        except IndexError:
            raise NoSuchError("%s[...]: %s, it has %d fields" % (type(self).__name__, _given(index), len(self))) from None

    def __setitem__(self, index, value):
        if not isinstance(index, str):
            try:
                index = list(self.kinds)[operator.index(index)]
            except TypeError:
                raise ArgumentTypeError("%s[...]: %s, the number or the name of a field is wanted" % (
                    type(self).__name__, _given(index))) from None
            except IndexError:
                raise NoSuchError("%s[...]: %s, it has %d fields" % (type(self).__name__, _given(index), len(self))) from None
        setattr(self, index, value)

    def keys(self):
        """The names of the fields: dict(struct) and pandas use them."""
        return list(self.kinds)

    def to_dict(self):
        """The fields as a dict of Python's own kinds: numbers, texts, tuples and lists. Bare pointers are left out."""
        return {name: _plain(getattr(self, name, None)) for name, kind in self.kinds.items() if not _raw(kind)}

    def __eq__(self, other):
        if isinstance(other, Struct) and (other.plain or type(other)) is not (self.plain or type(self)) and not (self.numbers and other.numbers):
            return False
        if not isinstance(other, (Struct, tuple, list)):
            return NotImplemented
        mine, others = ([item for item, kind in zip(struct, self.kinds.values()) if not _raw(kind)] if isinstance(struct, Struct)
                        else list(struct) for struct in (self, other))
        return len(mine) == len(others) and all(_same(a, b) for a, b in zip(mine, others))

    __hash__ = None

    def __reduce_ex__(self, _):
        own = self.plain or type(self)
        arrays = {name: data for name, data in ((name, _array_bytes(name, kind, self)) for name, kind in self.kinds.items()
                                                if isinstance(kind, View)) if data is not None}
        raw, c = {}, own.from_buffer_copy(self)             # pointers mean nothing elsewhere
        for (name, kind), field in zip(self._fields_, self.kinds):
            if isinstance(self.kinds[field], (View, Function)) or kind is ctypes.c_char_p or kind is ctypes.c_void_p or issubclass(
                    kind, ctypes._Pointer):
                if kind is ctypes.c_char_p and getattr(self, name) is not None:
                    raw[name] = getattr(self, name)
                ctypes.memset(ctypes.addressof(c) + getattr(type(self), name).offset, 0, ctypes.sizeof(kind))
        return _struct_from, (own, bytes(c), arrays, dict(self._functions or {}), raw)

    def __copy__(self):
        copy = (self.plain or type(self)).from_buffer_copy(self)    # its arrays are those of the original
        copy.__dict__.update(_functions=dict(self._functions or {}), _of=self._of, _ids=self._ids, _extra=(self._extra, self._objects))
        return copy

    def __deepcopy__(self, memo):
        make, arguments = self.__reduce_ex__(4)
        return make(*arguments)

    def __repr__(self):
        shown = []
        for name, value in zip(self.kinds, self):
            if isinstance(value, Array):
                value = "<%s>" % " x ".join(map(str, value.shape))
            elif isinstance(value, ctypes.Array):
                value = list(value)
            if value or not hasattr(value, "__len__"):
                shown.append("%s=%r" % (name, value))
        return "%s(%s)" % (type(self).__name__, ", ".join(shown))


Struct.needs = {}               # of a kind: fields without which it does nothing
Struct.uses = {}                # fields that have a use beside some others only: see _use
Struct.defaults = {}            # fields whose 0 means this value
Struct.positive = {}            # fields that must not be below 0, and what to write instead
Struct.required = ()            # fields without which it means nothing
Struct.whole = False            # a sequence must have all fields
Struct.plain = None             # of the class of a struct that a function may only read: the class without that


@functools.lru_cache(None)
def _read(kind):
    """The class of a struct that a function of yours receives and may only read."""
    return type(kind.__name__, (kind,), {"_call": "a function may only read it", "plain": kind, "__module__": kind.__module__,
                                         "__doc__": kind.__doc__})


def _field_at(struct, part):
    """The name of the field of a struct that contains a part of it."""
    at = ctypes.addressof(part) - ctypes.addressof(struct)
    return next((name for (raw, _), name in zip(struct._fields_, struct.kinds) if 0 <= at - getattr(type(struct), raw).offset < getattr(
        type(struct), raw).size), "")


def _world_call(name):
    """What changes a field of world.desc, as the end of an error message."""
    if isinstance(getattr(World, name, None), property) and getattr(World, name).fset:
        return "write world.%s = ..." % name
    return "call world.%s_set(...)" % name if hasattr(World, name + "_set") else "write dem.World(%s=...) when you make the world" % name


def _changed(base, what, field=None):
    """Refuses to change a part of a struct that a call has returned, or that a function may only read. field: of the struct
    itself."""
    first = base
    while base is not None:
        call = getattr(base, "_call", None)
        if callable(call):
            call = call(field or _field_at(base, first))
        if call:
            raise FieldError("%s cannot be set; %s" % (what, call) if getattr(base, "plain", None) else
                             "%s: this is a copy, whose change would have no effect; %s" % (what, call))
        base, field = getattr(base, "_b_base_", None), None


def _raw(kind):
    """True of a pointer that Python passes on and does not read."""
    return kind is ctypes.c_void_p


def _same(a, b):
    """Equality of two fields."""
    if isinstance(a, ctypes.Array):
        a = list(a)
    if isinstance(b, ctypes.Array):
        b = list(b)
    if isinstance(a, list) and isinstance(b, (list, tuple)):
        return len(a) == len(b) and all(map(_same, a, b))
    try:
        return bool(a == b)
    except ValueError:          # arrays of numpy
        return False


class Row:
    """An array inside of a struct, and what functions return as one: a sequence of numbers, or of structs. Numbers take part
    in sums and products; two rows are equal if their numbers are."""
    _call = None
    _name = ""                      # of numbers on bodies: their field, for error messages

    def __setitem__(self, index, value):
        _changed(self, "array[%s]" % (index,))
        try:
            ctypes.Array.__setitem__(self, index, value)
        except (TypeError, ValueError, IndexError) as error:
            raise self._wrong(index, error) from None

    def __getitem__(self, index):
        try:
            return ctypes.Array.__getitem__(self, index)
        except (TypeError, IndexError) as error:
            raise self._wrong(index, error) from None

    def _wrong(self, index, error):
        if isinstance(error, IndexError):
            text = "%s is given, the array has %s" % (
                index, "the numbers 0 to %d" % (len(self) - 1) if len(self) else "no numbers")
            return NoSuchError("%s: %s; World(body_reals=...) names %d" % (
                self._name, text, _reals_of(self.owner)) if self._name else text)
        return ArgumentTypeError("array[%s]: %s" % (index, error))

    def __iter__(self):
        return iter(ctypes.Array.__getitem__(self, slice(0, len(self))))

    def __repr__(self):
        return "[%s%s]" % (", ".join(map(repr, self[:24])), ", ... (%d in all)" % len(self) if len(self) > 24 else "")

    def __eq__(self, other):
        return len(self) == len(other) and all(map(_same, self, other)) if isinstance(other, (ctypes.Array, list, tuple)) else NotImplemented

    __hash__ = None

    def __reduce_ex__(self, _):
        if issubclass(self._type_, ctypes._Pointer):
            raise ArgumentTypeError("an array of pointers is not pickled; return its numbers")
        kind, lengths = self._type_, [len(self)]
        while issubclass(kind, Row):
            kind, lengths = kind._type_, lengths + [kind._length_]
        return _row_from, (kind, lengths, bytes(self))

    def __copy__(self):
        return _row(self._type_, len(self)).from_buffer_copy(self)

    def __deepcopy__(self, memo):
        return self.__copy__()

    def _with_each(self, other, function, swap=False):
        if self._type_ not in _NUMBERS:
            return NotImplemented
        if isinstance(other, (int, float)) or not hasattr(other, "__len__") and hasattr(other, "__float__"):
            other = (other,)*len(self)
        elif not isinstance(other, (Row, Numbers, tuple, list)) or len(other) != len(self):
            return NotImplemented                           # an array of numpy answers itself
        return _row(Real if self._type_ in _LIMITS else self._type_, len(self))(*[
            function(b, a) if swap else function(a, b) for a, b in zip(self, other)])


@functools.lru_cache(1024)
def _row(kind, length):
    """The type of an array of this length."""
    letters = "xyz" if length == 3 and kind in _NUMBERS else ""
    return type("Row", (Row, ctypes.Array), dict({"_type_": kind, "_length_": length, "__module__": __name__}, **{
        letter: property(operator.itemgetter(i)) for i, letter in enumerate(letters)}))


@functools.lru_cache(1024)
def _row_read(kind, length):
    """The type of an array that a function receives and may only read."""
    return type("Row", (_row(kind, length),), {"_call": "a function may only read it", "plain": True, "__module__": __name__})


def _row_from(kind, lengths, data):
    """An array that was pickled."""
    for length in reversed(lengths):
        kind = _row(kind, length)
    return kind.from_buffer_copy(data)


def _fixed(array):
    """An array of structs that a call has filled, whose fields are not set."""
    array._call = "dem.h computes it"
    return array


class Numbers(Struct):
    """A struct of real numbers, such as Vec3, which takes part in sums and products like an array of numpy."""

    def __array__(self, dtype=None, copy=None):
        import numpy
        return numpy.array(tuple(self), dtype=dtype)

    @staticmethod
    def _arrays(value):
        """A value with tuples in the places of structs of numbers."""
        if isinstance(value, Numbers):
            return value.__array__()
        if isinstance(value, (list, tuple)):
            return type(value)(map(Numbers._arrays, value))
        return value

    def __array_ufunc__(self, function, method, *inputs, **options):
        return getattr(function, method)(*Numbers._arrays(inputs), **options)

    def __array_function__(self, function, kinds, arguments, options):
        return function(*Numbers._arrays(arguments), **options)

    def _with_each(self, other, function, swap=False):
        if isinstance(other, (int, float)) or not hasattr(other, "__len__") and hasattr(other, "__float__"):
            other = (other,)*len(self)
        elif not isinstance(other, (Numbers, Row, tuple, list)) or len(other) != len(self):
            return NotImplemented                           # an array of numpy answers itself
        return type(self)(*[function(b, a) if swap else function(a, b) for a, b in zip(self, other)])

    def _in_place(self, other, function, sign):
        """v += w and the like, which change v itself: `force += ...` in a function of yours has an effect on its argument."""
        name = type(self).__name__
        if getattr(self._b_base_, "_assigns", None):        # of a property with a setter, which gets the sum
            return self._with_each(other, function)
        _changed(self, "%s %s ..." % (name, sign))
        if hasattr(other, "__len__") and not isinstance(other, (Numbers, Row, tuple, list)):
            try:
                other = _items(other, "%d numbers" % len(self))     # an array of numpy would take the place of v
            except TypeError as error:
                raise _named(error, "%s %s ..." % (name, sign)) from None
        made = self._with_each(other, function)
        if made is NotImplemented:
            raise ArgumentTypeError("%s %s ...: %s, a number or %d numbers are wanted" % (name, sign, _given(other), len(self)))
        for i, value in enumerate(made):
            self[i] = value
        return self

    def __iadd__(self, other):
        return self._in_place(other, operator.add, "+=")

    def __isub__(self, other):
        return self._in_place(other, operator.sub, "-=")

    def __imul__(self, other):
        return self._in_place(other, operator.mul, "*=")

    def __itruediv__(self, other):
        return self._in_place(other, operator.truediv, "/=")

    def __add__(self, other):
        return self._with_each(other, operator.add)

    __radd__ = __add__

    def __sub__(self, other):
        return self._with_each(other, operator.sub)

    def __rsub__(self, other):
        return self._with_each(other, operator.sub, True)

    def __mul__(self, other):
        return self._with_each(other, operator.mul)

    __rmul__ = __mul__

    def __truediv__(self, other):
        return self._with_each(other, operator.truediv)

    def __rtruediv__(self, other):
        return self._with_each(other, operator.truediv, True)

    def __neg__(self):
        return type(self)(*[-a for a in self])

    def __pos__(self):
        return type(self)(*self)

    def __abs__(self):
        return math.sqrt(sum(a*a for a in self))

    def dot(self, other):
        """The scalar product with three (Quat: four) numbers."""
        return sum(a*b for a, b in zip(self, type(self)._made(other)))


for _name in "add radd sub rsub mul rmul truediv rtruediv abs iadd isub imul itruediv".split():
    setattr(Row, "__%s__" % _name, getattr(Numbers, "__%s__" % _name))
Row._in_place = Numbers._in_place


class Vector(Numbers):
    """What a Vec3 has beside its fields: v + w, 2*v, v/2, abs(v) (its length), v.dot(w), v.cross(w)."""

    def cross(self, other):
        """The vector product."""
        (a, b, c), (x, y, z) = self, type(self)._made(other)
        return type(self)(b*z - c*y, c*x - a*z, a*y - b*x)


def _field(name, kind, doc):
    """A property for a field whose C value is not what Python users expect."""
    raw = "_" + name

    def get(self):
        value = getattr(self, raw)
        if isinstance(kind, Function):
            return (self._functions or {}).get((name,)) or (value if value else None)
        if isinstance(kind, Choices):
            return tuple(kind.kind(item) for item in value)
        if isinstance(kind, Text):
            return value.decode(errors="replace")
        if kind is str:
            return None if value is None else value.decode(errors="replace")
        if isinstance(kind, _Known):
            if value < 0:
                raise AttributeError                        # __getattr__ says why
            return value
        try:
            return kind(value)
        except ValueError:
            return value

    def view(self):
        value = getattr(self, raw)
        if kind.one:
            return value[0] if value else None
        if kind.shape == ("_per_body",):
            return _reals_at(value, kind, self, name)
        shape = []
        for axis in kind.shape:
            length = getattr(self, axis) if type(axis) is str else axis
            if isinstance(length, Row):                     # cells along three axes
                length = length[0]*length[1]*length[2]
            shape.append(length)
        if kind.times:
            count = getattr(self, name + "_count") if name + "_count" in self.kinds else kind.times
            return tuple(_view(pointer, kind.kind, shape, self, kind.const, name) for pointer in value[:count])
        return _view(value, kind.kind, shape, self, kind.const, name)

    def put(self, value):
        if isinstance(kind, Function):
            if self._b_base_ is not None:
                raise TypeError("this struct is a part of another; make it with its function, then assign it")
            functions = dict(self._functions or {})
            functions.pop((name,), None)
            if value is None:
                _set(self, raw, kind.c())
            elif isinstance(value, ctypes._CFuncPtr):       # a function compiled in C
                _compiled(value)
                _set(self, raw, ctypes.cast(value, kind.c))
            elif callable(value) and not isinstance(value, type):
                functions[name,] = value
            else:
                raise TypeError("%s, a function is wanted" % _given(value))
            self.__dict__["_functions"] = functions
        else:
            _set(self, raw, _convert(value, kind))
    return property(view if isinstance(kind, View) else get, put, doc=doc)


def _reals_of(struct):
    """How many numbers on bodies the pointers of a struct show; 0 of a copy, whose pointers may be void."""
    return struct._per_body or getattr(struct._b_base_, "_per_body", 0)


def _reals_at(pointer, kind, owner, name):
    """The numbers on a body behind a pointer, which refuse other indices by name."""
    row = (_row_read if kind.const else _row)(kind.kind, _reals_of(owner) if pointer else 0)
    row = row.from_address(ctypes.addressof(pointer.contents)) if row._length_ else row()
    row.owner, row._name = owner, "%s.%s" % (type(owner).__name__, name)
    if owner._of:
        row._call = "call body.reals_set(...)"
    return row


def _compiled(function):
    """Refuses a function of a library that was compiled for another precision."""
    for library in (getattr(function, "_objects", None) or {}).values():
        if isinstance(library, ctypes.CDLL):
            try:
                size = ctypes.c_int.in_dll(library, "dempy_real_size").value
            except ValueError:
                continue
            if size != ctypes.sizeof(Real):
                raise ValueError("the library %s is compiled for reals of %d bytes, this process has %d; compile it again with "
                                 "dem.compile" % (library._name, size, ctypes.sizeof(Real)))


def _struct(cls):
    """Gives a subclass of Struct the fields of its rows."""
    fields, docs, kinds = [], [], {}
    cls._functions_ = {}
    for name, kind, doc in cls.rows:
        if isinstance(kind, View) and not kind.shape and not kind.one:
            kind.shape = tuple(length for length, arrays in cls.counts.items() if name in [array for array, _ in arrays])
        if isinstance(kind, type) and issubclass(kind, ctypes.Array):
            kind = _row(kind._type_, kind._length_)
        kinds[name] = kind
        special = isinstance(kind, (View, Text, Function, Choices, _Known)) or kind is str or issubclass(
            kind, enum.IntEnum)
        c = ctypes.c_char_p if kind is str else _c(kind)
        fields.append(("_" + name if special else name, c))
        if isinstance(kind, Function):
            cls._functions_[name] = kind
        if special:
            setattr(cls, name, _field(name, kind, doc))
        if doc is None:                                     # shares the comment of the field before it
            docs[-1] = re.sub("(?=: )", ", " + name, docs[-1], count=1)
        elif doc:
            docs.append("%s: %s" % (name, doc))
    cls.kinds = kinds
    cls.counted = {field for arrays in cls.counts.values() for field, _ in arrays if not isinstance(cls.kinds[field], View)}
    cls.numbers = issubclass(cls, Numbers)
    cls.whole = cls.__name__ == "Box"
    cls._fields_ = fields
    if docs:
        cls.__doc__ = "\n".join(line.strip() for line in (cls.__doc__ or "").split("\n")).strip() + "\n\n" + "\n".join(docs)
    return cls


class Id(Struct):
    """The id of an object of a world. Two ids are equal if they name the same object."""

    @classmethod
    def _made(cls, value):
        """An id from an id; None is the id 0, which names nothing."""
        if type(value) is cls:
            return value
        if value is None:
            return cls()
        raise TypeError(_wanted(value, cls))

    def __setattr__(self, name, value):
        if name[:1] != "_":
            kind = type(self)
            one = kind.__name__.lower()
            if hasattr(kind, name + "_set"):
                call = "call %s.%s_set" % (one, name)
            elif hasattr(kind, "set") and name in kind.set.__wrapped__.__code__.co_varnames:
                call = "write %s.set(%s=...)" % (one, name)
            else:
                call = "an id does not change, and its object has %s" % ", ".join(
                    word for word in dir(kind) if word[0] != "_" and word not in dir(Id))
            raise FieldError("%s.%s cannot be set; %s" % (kind.__name__, name, call))
        _set(self, name, value)

    def __getattr__(self, name):
        raise _no_attribute(self, name)

    def of(self, world):
        """The same id, as a part of another world: of a copy that a function of yours sees, or of a checkpoint."""
        if not isinstance(world, WorldBase):
            raise ArgumentTypeError("%s.of: world: %s, a World is wanted" % (type(self).__name__, _given(world)))
        copy = type(self).from_buffer_copy(self)
        copy._of = world
        return copy

    @property
    def world(self):
        """The world that it belongs to."""
        if self._of is None:
            raise ArgumentError("%r belongs to no world yet; write id.of(world)" % self)
        return self._of

    def __reduce_ex__(self, _):
        return _struct_from, (type(self), bytes(self), {}, {}, {})

    def __bool__(self):
        return any(bytes(self))

    def __eq__(self, other):
        return type(self) is type(other) and bytes(self) == bytes(other)

    def __hash__(self):
        return hash((type(self), bytes(self)))


# ---- worlds -------------------------------------------------------------------------------------

class _Context:
    """What the functions that a world calls share: the first exception, and the world."""

    def __init__(self, world):
        self.raised, self.kept, self.go_on, self.memory, self.vectors, self.reals = None, {}, None, 0, 0, 0
        self.world_of, self.runs, self.ids, self.stop = weakref.ref(world), None, None, False
        self.spoils, self.spoilt, self.names = None, None, {}   # the function that raised; the same, and the step

    def fail(self, error, kind=None):
        """Notes an exception of a function. kind: of one whose failure spoils the state, such as a law."""
        if self.raised is None:
            self.raised = error
        if kind and not self.spoils:
            self.spoils = self.names.get(kind, kind)

    def world(self, pointer):
        world = self.world_of()
        return world if world is not None and world._at == pointer else World._borrow(pointer, self)


def _held(value):
    """True if something holds an object beside the variable of the caller. A dict of the caller's variables, which debuggers
    and World.close make, does not count."""
    more = _refs(value) - _TWO
    return more > 0 and more > sum(type(holder) is dict and "context" in holder and "function" in holder
                                   for holder in gc.get_referrers(value))


def _references():
    value = object()
    return _refs(value), (lambda value: _refs(value))(value)


_ONE, _TWO = _references()


def _kept(name, kind):
    """The exception of a function that keeps an argument whose memory dem.h uses again."""
    return ArgumentError("your function (%s) keeps its argument %s, whose memory dem.h uses again after the call; keep a copy: "
                         "copy.copy(%s), or the numbers that you need" % (kind, name, name))


def _beyond(error, kind, **arrays):
    """The exception of a function that used a number beyond the arrays that it receives, in the place of that of ctypes."""
    if str(error) != "invalid index":
        return error
    what = {"memory": ("contact history", "World(law_memory=...)"), "values": ("row of columns", "output(columns=...)"),
            "reals": ("numbers of the body", "World(body_reals=...)"), "rates": ("rates", "World(body_reals=...)")}
    words = ["its %s has %s (%s)" % (what[name][0], "the numbers 0 to %d" % (kind_._length_ - 1) if kind_._length_ else "no numbers",
                                     what[name][1]) for name, kind_ in arrays.items()]
    made = NoSuchError("your function (%s) used a number beyond an array: %s" % (kind, "; ".join(words)))
    made.__cause__ = error
    return made.with_traceback(error.__traceback__)


def _returned(value, kind):
    """The exception of a function that returns what it must not."""
    return ArgumentTypeError("your function (%s) returned %s, but what it returns has no effect; it sets the fields of its "
                             "arguments and returns nothing" % (kind, _given(value).replace(" is given", "")))


def _real_from(value, kind):
    """A number that a function of yours returned."""
    try:
        return _number(value, ctypes.c_double)
    except TypeError as error:
        raise ArgumentTypeError("your function (%s) must return a number: %s" % (
            kind, str(error).replace("is given", "was returned"))) from None


def _no_attribute(thing, name):
    """The exception for an attribute that an id, a struct or a world does not have. It names what has one like it."""
    kind = type(thing)
    if name in getattr(kind, "kinds", ()):
        return NoFieldError("%s.%s: bodies or walls were added, removed or changed after the last step, so the "
                            "contacts are not known; first call world.step() or world.contacts_each()" % (
                                kind.__name__, name))
    if name[:1] == "_" or name in ("shape", "dtype", "tolist"):     # what numpy and others look for
        return AttributeError("%s has no attribute %r" % (kind.__name__, name))
    one, parts = kind.__name__.lower(), dict(_PARTS.get(kind.__name__, {}))
    if parts.pop("bodies_memory", None):                    # its rows change their order
        parts["bodies"] = Bodies
    order = sorted(parts, key=lambda part: {"desc": 1, "state": 1, "bodies": 2, "totals": 2, "ledger": 4}.get(part, 3))
    meant = _MEANT.get(name) or re.sub("^(set|get|add)_", "", name)
    found = ["%s.%s.%s" % (one, part, meant) for part in order if meant in parts[part].kinds]
    words = [word for word in dir(kind) if word[0] != "_" and word not in dir(Struct)]
    if meant + "s" in words:
        found.insert(0, "%s.%ss" % (one, meant))
    if meant != name and meant in words:
        found.insert(0, "%s.%s" % (one, meant))
    if name.endswith("_add") and name[:-4] in words:        # as in C
        found.insert(0, "%s.%s" % (one, name[:-4]))
    if name in ("walls", "materials", "shapes", "feeds", "outlets", "fields") and kind.__name__ == "World":
        return NoFieldError("World has no attribute %r; keep what the calls that add them return, world.%s(...)" % (name, {
            "walls": "wall_plane", "shapes": "shape_ellipsoid"}.get(name, name[:-1])))
    if found:
        return NoFieldError("%s has no attribute %r; read %s" % (kind.__name__, name, " or ".join(found[:2])))
    import difflib

    fields = {field: "%s.%s" % (part, field) for part in reversed(order) for field in parts[part].kinds}
    near = difflib.get_close_matches(meant, words + [field for field in fields if field not in words], 2)
    if not near or name.startswith("add_"):
        near = [word for word in words if meant in word.split("_")][:3] or near
    return NoFieldError("%s has no attribute %r%s" % (kind.__name__, name, "; did you mean %s?" % " or ".join(
        "%s.%s" % (one, fields.get(word, word) if word not in words else word) for word in near) if near else _near(name, words)))


_MEANT = {      # names that other codes use
    "angular_velocity": "spin", "omega": "spin", "save": "checkpoint_write", "load": "checkpoint_read", "dump": "checkpoint_write",
    "angular_velocities": "spins", "set_dt": "dt_set"}


def _no_groups(name):
    return ArgumentError("World.group: %s, but this world has no groups; name them when you make it: dem.World(groups=%r)" % (
        _given(name), name))


def _seen(contact, memory):
    """For world.contacts_each() without a function, which counts."""


def _no_ledger():
    return ArgumentError("World.ledger: this world keeps no account of energy; make it with dem.World(ledger=1)")


def _in_python(text):
    """An error message of dem.h, with the functions that it recommends as they are called in Python."""
    head, colon, rest = text.partition(": ")
    return head + colon + _said(rest)


def _with_rows(text, rows):
    """An error message of dem.h about a body that a call adds, with the array of the call and the index in it."""
    def named(found):
        """The array and the index; the field alone if the call has no such array."""
        one, index = found.groups()
        array = {"velocity": "velocities", "radius": "radii"}.get(one, one + "s")
        return "%s[%s]" % (array, index) if array in rows.keys() and rows[array] is not None else one
    return re.sub(r"(?:the )?\b(\w+) of (?:body|sphere) (\d+)(?= is )", named, text)


def _said(text):
    """A text of dem.h, with functions, fields and constants as they are written in Python."""
    names = {function.replace("dempy_", "dem_"): name[0].lower() + name[1:] if "." in name else "dem." + name
             for function, _, _, name, _ in _FUNCTIONS if not function.startswith(("dempy_rows", "dempy_ids", "dempy_put"))}
    for words, in_python in _PHRASES:
        text = re.sub(words, in_python, text)
    text = re.sub(r"\bdem_\w+\b", lambda found: names.get(found.group(0), found.group(0)), text)
    return re.sub(r"\bDEM_\w+\b", lambda found: _CONSTANTS.get(found.group(0), found.group(0)), text)


def _desc_field(found):
    """A field of a desc in an error message of dem.h."""
    name = found.group(1)
    return "World(%s=...)" % name if name in WorldDesc.kinds else name


_PHRASES = (        # of error messages of dem.h, and what is written in Python
    (r"start from DEM_SIZES and set what this kind needs", "give the fields that this kind needs"),
    (r"start from DEM_[A-Z]+(?:_DESC)? and set (?=\w+$)", "give "),
    (r"; start from DEM_[A-Z]+(?:_DESC)?(?: and set only what differs)?", ""),
    (r"start from dem_pair_get and change only what differs", "give only the fields that change"),
    (r"^(\w+) is 0([^,;]*, must be [^;]*); set it in the desc before the call", r"\1 is 0\2; give \1=..."),
    (r"; set it in the desc before the call", ""),
    (r"\b(is|are) null\b", r"\1 None"),
    (r"\bnull\b", "None"),
    (r"; give its address\b", "; give one"),
    (r"\bset motion\.(\w+)", r"give \1=..."),
    (r'as \{"height", "m", dem_observer_height, 0, 0\}', 'as dem.Observable(name="height", unit="m", function=dem.World.observer_height)'),
    (r"\bfirst call dem_world_step\b", "first call world.step()"),
    (r"\bdem_contacts_each, which", "world.contacts_each(), which"),
    (r"set desc\.boundary\[(\d)\] to DEM_BOUNDARY_PERIODIC", r"make axis \1 periodic with World(boundary=...)"),
    (r"an output of kind DEM_OUTPUT_CALL", "an output of kind 'call', world.output(kind='call', function=...)"),
    (r"\bdesc\.(\w+) = (\w+)", r"World(\1=\2)"),
    (r"; set it when the world is created", "; set it when you make the world"),
    (r"(?<![\w.])desc\.(\w+)(?!\w|\()", _desc_field),
    (r"\bmust be a DEM_[A-Z]+_ value", "must be one of its words"),
)


_thread = threading.get_ident


class Handle:
    """A world, a replay or slabs: memory that the library owns."""
    _at = _context = None

    def __getattr__(self, name):
        raise _no_attribute(self, name)

    @property
    def _c(self):
        """The pointer, for a call."""
        at, context = self._at, self._context
        if at is None or context and context.runs is not None and context.runs != _thread():
            self._refuse()
        return at

    def _refuse(self):
        """Raises if this is closed, or if another thread runs the world. A law may be called in any thread of the run."""
        frame = sys._getframe(2)                            # of a method, perhaps of an id
        own = frame.f_locals.get("self", self)
        name = "%s.%s" % ("World.bodies" if isinstance(own, Rows) else type(own).__name__, frame.f_code.co_name)
        if self._at is None:
            raise ArgumentError("%s: this %s is closed" % (name, type(self).__name__.lower()))
        if not self._called():
            raise ArgumentError("%s: another thread runs this world; one thread at a time may use a world" % name)

    def __setattr__(self, name, value):
        found, kind = getattr(type(self), name, None), type(self).__name__
        if name[:1] == "_" or isinstance(found, property) and found.fset:
            object.__setattr__(self, name, value)
        elif hasattr(type(self), name + "_set"):
            raise FieldError("%s.%s: an assignment has no effect; call %s_set" % (kind, name, name))
        elif isinstance(self, WorldBase) and name in WorldDesc.kinds:
            raise FieldError("%s.%s is fixed when the world is made; write dem.World(%s=...)" % (kind, name, name))
        elif found is not None:
            raise FieldError("%s.%s cannot be set; dem.h computes it" % (kind, name) if isinstance(found, property) else
                             "%s.%s is a method; call it" % (kind, name))
        else:
            raise FieldError("%s has no attribute %r that can be set; keep what is yours in a variable of your own" % (kind, name))

    def _text(self):
        return ""

    def _raise(self, kind, rows=None):
        text = _in_python(self._text() or "no message")
        if rows is not None:
            text = _with_rows(text, rows)
        if kind is Error:                                   # a null id
            kind = (MemoryError if ": out of memory" in text else FileError if ": cannot write" in text or ": cannot read" in text
                    else ArgumentError)
        runs, spoilt = (self._context.runs, self._context.spoilt) if self._context else (None, None)
        if spoilt and kind is UnstableError:
            head, _, rest = text.partition(": ")
            text = "%s: your function (%s) raised at step %d of this world; read a checkpoint or build it again; %s" % (head, *spoilt, rest)
        if runs and runs != threading.get_ident() and "called from a function that" in text:
            text = "%s: another thread runs this world; one thread at a time may use a world" % text.partition(":")[0]
        raise kind(text)

    def _ok(self, result, rows=None):
        """Raises the exception of a function of yours, or that of a result other than OK. rows: arrays of the call."""
        if self._context and self._context.raised is not None:
            error, self._context.raised = self._context.raised, None
            if self._context.spoils and not self._context.spoilt and isinstance(self, WorldBase) and self._at == self._memory.at:
                self._context.spoilt = self._context.spoils, _lib.dem_world_steps_get(self._at)
            self._context.spoils = None
            self._text()                                    # a consequence: read, so that no run quotes it later
            raise error
        if result:
            self._raise(_ERRORS[result], rows)

    def _run(self, function, *arguments):
        """Calls a function that takes long. Ctrl-C meanwhile is noted: a progress function then ends the run, and the
        caller gets KeyboardInterrupt."""
        context, thread = self._context, threading.get_ident()
        outer, context.runs, context.stop = context.runs, thread, False
        before = _signal.getsignal(_signal.SIGINT) if thread == threading.main_thread().ident else None
        _RUNNING.add(context)
        try:
            if not callable(before):
                return function(*arguments)

            def note(number, frame):
                try:
                    before(number, frame)
                except BaseException as error:
                    context.fail(error)
            _signal.signal(_signal.SIGINT, note)
            try:
                return function(*arguments)
            finally:
                _signal.signal(_signal.SIGINT, before)
        finally:
            context.runs = outer
            if not outer:
                _RUNNING.discard(context)
            if context.stop:                                # Ctrl-C, and another thread is the main thread
                context.stop = False
                context.fail(KeyboardInterrupt())

    def _id(self, value):
        self._ok(0)
        if not value:
            self._raise(Error, {})
        value._of = self
        return value

    def _pointer(self, value):
        self._ok(0)
        if not value:
            self._raise(Error)
        return value

    def _number(self, value):
        """A count, or a fraction: -1 is an error."""
        self._ok(0)
        if value < 0:
            self._raise(Error)
        return value

    def _filled(self, added, count, name):
        """The number of bodies that a fill has added. Fewer than `count` are a warning, none are an error."""
        self._ok(0)
        if added < count or added == 0:
            text = self._text()
            if added == 0 and (count or text.startswith(name)):
                self._raise(Error)
            if added:
                warnings.warn(_in_python(text), stacklevel=4)
        return added

    def _bound(self, struct, key=None):
        """A struct whose Python functions have become C functions, which live as long as the world."""
        for name, item in (struct._ids or {}).items():
            if item._of._at != self._at:
                raise ArgumentError("%s.%s: %s: %r belongs to another world%s" % (
                    type(self).__name__, sys._getframe(1).f_code.co_name, name, item, "" if item._of._at else ", which is closed"))
        if not struct._functions:
            return struct
        copy = type(struct).from_buffer_copy(struct)
        copy._extra = struct
        made = []
        for path, function in struct._functions.items():
            target = copy
            for step in path[:-1]:
                target = target[step] if isinstance(step, int) else getattr(target, step)
            kind = target._functions_[path[-1]]
            entry = kind.wrap(function, self._context, target)
            setattr(target, "_" + path[-1], entry)
            made.append(entry)
        self._context.kept[key or len(self._context.kept)] = made, struct
        return copy

    def _callback(self, kind, function, where):
        """A C function of a Python function, for one call. where: the call and the argument."""
        if function is _go_on and self._context.go_on:
            return self._context.go_on
        if function is None:
            return kind.c()
        if not callable(function) or isinstance(function, type):
            raise ArgumentTypeError("%s: %s, a function is wanted%s" % (where, _given(function), "; world.run(1, dem.progress_print) prints "
                                                                        "the progress" if where.endswith(": progress") else ""))
        if function is _go_on:
            self._context.go_on = kind.wrap(_go_on, self._context, None)
            return self._context.go_on
        if isinstance(function, ctypes._CFuncPtr):
            return ctypes.cast(function, kind.c)
        return kind.wrap(function, self._context, None)

    def _with(self, struct, call="dem.h computes it"):
        """Ties a struct that the library has filled to the world, whose memory its views keep alive. call: what changes
        the values that it shows."""
        struct.__dict__.update(_of=self, _extra=self._memory, _call=call, _per_body=self._context.reals)
        if type(struct) is WallLoads and struct._contacts and not _lib.dem_counters_get(self._at).wall_contacts:
            struct._contacts = -1 if _lib.dem_bodies_get(self._at).count else 0     # those of bodies that may be gone
        return struct

    def _print(self, function, out, *arguments):
        """Calls a function that prints to a FILE, and prints its text to `out` (sys.stdout)."""
        if out is not None and not hasattr(out, "write"):
            raise ArgumentTypeError("%s: out: %s, a file of Python is wanted" % (sys._getframe(1).f_code.co_name, _given(out)))
        libc = ctypes.CDLL(None) if os.name == "posix" else ctypes.cdll.ucrtbase
        libc.tmpfile.restype = ctypes.c_void_p
        file = ctypes.c_void_p(libc.tmpfile())
        if not file:
            raise OSError("tmpfile() failed: is the folder for temporary files writable?")
        try:
            result = function(*arguments, file)
            size = libc.ftell(file)
            libc.rewind(file)
            text = ctypes.create_string_buffer(max(size, 1))
            size = libc.fread(text, 1, size, file)
        finally:
            libc.fclose(file)
        print(_said(text.raw[:size].decode(errors="replace")), end="", file=out or sys.stdout)
        self._ok(0)
        return result

    def _taken(self, struct, free):
        """A copy of a struct in memory of Python; frees the memory of the library."""
        copy = type(struct).from_buffer_copy(struct)
        copy._extra = []
        for name, kind in struct.kinds.items():
            pointer = getattr(struct, "_" + name) if isinstance(kind, View) else None
            if pointer:
                view = getattr(struct, name)
                if view is None:                            # no numbers
                    setattr(copy, "_" + name, None)
                    continue
                array = (kind.kind*(view.nbytes//ctypes.sizeof(kind.kind))).from_buffer_copy(view.cast("B"))
                copy._extra.append(array)
                setattr(copy, "_" + name, ctypes.cast(array, kind.c))
        free(self._at, struct)
        return copy

    def __reduce_ex__(self, _):
        raise ArgumentTypeError("a %s owns memory of dem.h and cannot be copied or pickled; write and read a checkpoint"
                                % type(self).__name__)

    def close(self):
        """Ends it and frees its memory; further calls raise an error. Leaving a `with` block does the same."""
        if self._at is not None:
            if self._context and self._context.runs or self._called():
                raise ArgumentError("%s.close: a function of yours that dem.h calls, or another thread, cannot close what runs; "
                                    "return true from a progress function to stop a run" % type(self).__name__)
            self._free()

    def _called(self):
        """True inside of a function that dem.h calls for this world."""
        frame = sys._getframe(1)
        while frame is not None:
            if frame.f_code.co_name == "call" and frame.f_code.co_filename == __file__ and frame.f_locals.get(
                    "context") is self._context is not None:
                return True
            frame = frame.f_back
        return False

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __del__(self):
        try:
            if self._at is not None:
                self._free()
        except Exception:
            pass


class _Film:
    """An open replay of the library; at: None when it is closed."""

    def __init__(self, at, path):
        self.at, self.path = at, path


def _has_frames(path):
    """False if a replay has no frames; True if it cannot be read any more."""
    try:
        with open(path, "rb") as page:
            return any(b'<script type="dem/frame">' in line for line in page)
    except OSError:
        return True


class _Memory:
    """A world of the library, with its open replays. When neither the World nor a view of its arrays is left, completes
    the replays and destroys the world. The garbage collector ends the objects of a cycle in any order, so a World and a
    Replay read here whether they are open."""

    def __init__(self, at, context):
        self.at, self.context, self.films = at, context, set()

    def complete(self, film):
        at, film.at = film.at, None
        self.films.discard(film)
        result = _lib.dem_replay_close(at)
        if not result and not _has_frames(film.path):
            warnings.warn("%s has no frames and shows nothing: give World.replay(interval=...) before a run, or call "
                          "Replay.frame_write" % film.path, stacklevel=5)
        return result

    def __del__(self):
        try:
            for film in list(self.films):
                self.complete(film)
            at, self.at = self.at, None
            _lib.dem_world_destroy(at)
        except Exception:
            pass


class WorldBase(Handle):
    """What a World has beside the functions of dem.h."""
    _memory = None

    @property
    def _at(self):
        return self._memory.at if self._memory else None

    @property
    def _c(self):                                   # that of Handle, faster
        memory, runs = self._memory, self._context.runs
        if memory is None or runs is not None and runs != _thread():
            self._refuse()
        return memory.at

    def _create(self, desc):
        self._context = _Context(self)
        desc._functions = dict(desc._functions or {})
        functions = {path[0] for path in desc._functions}
        if functions & {"law", "law_rate", "force", "body_force", "body_reals_fn"} and not desc.threads:
            desc.threads = 1                        # Python runs one function at a time
        if "force" in functions:                    # ctypes has no functions that return a struct
            force, whole = desc._functions.pop(("force",)), desc._functions.get(("body_force",))
            if not whole:
                self._context.names["body_force"] = "force"

            def both(body, id, time, sum, torque):
                made = force(body.position, body.velocity, body.radius, body.mass, time)
                try:
                    sum.x, sum.y, sum.z = made
                except (TypeError, ValueError) as error:
                    raise ArgumentTypeError("your function (force) must return three numbers: %s" % _given(made).replace(
                        "is given", "was returned")) from error
                if whole:
                    whole(body, id, time, sum, torque)
            desc._functions["body_force",] = both
        for name in ("groups", "body_reals", "law_memory_names"):
            words = (getattr(desc, name) or "").split()
            twice = [word for i, word in enumerate(words) if word in words[:i]]
            if twice:
                raise ArgumentError("World: %s: %r is given twice; names must differ" % (name, twice[0]))
        self._context.memory, self._context.vectors = desc.law_memory, desc.law_vectors
        law = desc._functions.get(("law",))
        if not desc.law_who and "who" in getattr(getattr(law, "__code__", None), "co_names", ()):
            warnings.warn("World: law reads c.who, which is zeros unless you give law_who=1", stacklevel=5)
        self._context.reals = len((desc.body_reals or "").split())
        if "law" in functions:
            for renew in _PROOFS:
                renew()
        bound = self._bound(desc, "desc")
        at = _lib.dem_world_create_checked(bound, VERSION, ctypes.sizeof(Real))
        if not at:
            text = (_lib.dem_world_create_error_get(bound) or b"").decode()
            name = text.partition(": ")[2].partition(" ")[0]
            value = getattr(desc, name, None) if name in desc.kinds else None
            raise ArgumentError(_in_python(text) + ("; %s=%r is given" % (name, value) if type(value) in (int, float) else ""))
        self._memory = _Memory(at, self._context)

    @classmethod
    def _borrow(cls, pointer, context):
        """A world that belongs to the library: a copy that a function of yours sees."""
        world = cls.__new__(cls)
        world._context, world._memory = context, types.SimpleNamespace(at=pointer, films=())
        return world

    def _text(self):
        return (_lib.dem_world_error_get(self._at) or b"").decode(errors="replace")

    @property
    def gravity(self):
        """The acceleration of gravity, m/s2. An assignment calls gravity_set."""
        desc = self.desc
        desc.__dict__.update(_call="write world.gravity = (x, y, z)", _assigns=True)
        return desc.gravity

    @gravity.setter
    def gravity(self, value):
        self.gravity_set(value)

    @property
    def dt(self):
        """The time step in use, s; 0 before the first step if dem.h chooses it. An assignment calls dt_set."""
        return self.desc.dt

    @dt.setter
    def dt(self, value):
        self.dt_set(value)

    @property
    def bodies(self):
        """The arrays of all bodies, by the order of their slots: the order of adding, as long as none is removed. See
        Rows."""
        self._c
        return Rows(self)

    def __len__(self):
        return self.bodies.count

    def __bool__(self):
        return True

    def __repr__(self):
        if self._at is None:
            return "<World, closed>"
        if self._context.runs not in (None, _thread()) and not self._called():
            return "<World, run by another thread>"
        shown = self.body_counts
        return "<World at %.6g s: %d bodies, step %d>" % (self.time, shown.present, self.steps)

    def _free(self):
        try:
            results = [self._memory.complete(film) for film in list(self._memory.films)]
            if any(results):
                self._raise(_ERRORS[max(results)])
        finally:
            self._memory = None                     # views of arrays may hold it longer


class ReplayBase(Handle):
    """What a Replay has beside the functions of dem.h. It is recorded until it or its world is closed."""

    def __init__(self, at, world, path):
        self._film, self._world, self._context, self._memory, self._path = _Film(at, path), world, world._context, world._memory, path
        self._memory.films.add(self._film)

    @property
    def _at(self):
        return self._film.at

    @property
    def path(self):
        """The path of the file."""
        return self._path

    def __repr__(self):
        return "<Replay %s, %s>" % (self._path, "closed" if self._at is None else "open")

    def __del__(self):
        pass                                        # the world goes on recording

    def _repr_html_(self):
        return Page(self.path)._repr_html_() if self._at is None else "<p>close the replay to see it</p>"

    def _text(self):
        return self._world._text()

    def _free(self):
        result = self._memory.complete(self._film)
        if result:
            self._raise(_ERRORS[result])


class SlabsBase(Handle):
    """What Slabs have beside the functions of dem.h."""

    def __init__(self, at, world):
        self._at, self._world, self._context, self._memory = at, world, world._context, world._memory

    def _text(self):
        return (_lib.dem_slabs_error_get(self._at) or b"").decode(errors="replace")

    def _free(self):
        at, self._at = self._at, None
        _lib.dem_slabs_destroy(at)


def progress_print(world, done, seconds_left):
    """Prints the progress of a run to sys.stderr, a line for every tenth of the run: world.run(1, dem.progress_print). In a
    notebook it rewrites one line."""
    if not isinstance(world, WorldBase):
        raise ArgumentTypeError("dem.progress_print: world: %s, a World is wanted" % _given(world))
    if "ipykernel" not in sys.modules:
        world._print(_lib.dem_progress_print, sys.stderr, world._c, done, seconds_left)
        return
    text = io.StringIO()
    world._print(_lib.dem_progress_print, text, world._c, done, seconds_left)
    if text.getvalue().strip():                             # it prints a line for every tenth
        print("\r" + " ".join(text.getvalue().split("\n")).strip().ljust(100), end="\n" if done >= 1 else "", file=sys.stderr, flush=True)


_RUNNING = set()                # contexts of the worlds that run


def _interrupted(number, frame):
    """The handler of Ctrl-C: ends the runs of all threads, then does what Python does."""
    for context in list(_RUNNING):
        context.stop = True
    signal.default_int_handler(number, frame)


if threading.current_thread() is threading.main_thread() and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
    signal.signal(signal.SIGINT, _interrupted)


def _go_on(world, done, seconds_left):
    """The progress function of runs that are given none: lets Python handle Ctrl-C."""


@ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_double, ctypes.c_double, ctypes.c_void_p)
def _trials_stopped(world, done, seconds_left, user):
    """The progress function of the runs of World.trials_run: lets Python handle Ctrl-C, after which it stops them."""
    return any(context.raised is not None or context.stop for context in list(_RUNNING) if context.runs == _thread())


@functools.lru_cache(None)
def _history(count, vectors):
    """The type of a contact history: `vectors` of its leading triples are vectors."""
    return type("History", (ctypes.Array,), {"_type_": Real, "_length_": count, "vectors": vectors, "__doc__": "A contact history."})


def tail(memory, first):
    """The numbers of a contact history from number `first` on, for built-in laws that follow another one."""
    if not isinstance(memory, ctypes.Array) or memory._type_ is not Real:
        raise ArgumentTypeError("dem.tail: memory: %s, the contact history that a law receives is wanted" % _given(memory))
    try:
        first = _number(first, ctypes.c_int)
    except (TypeError, OverflowError) as error:
        raise _named(error, "dem.tail: first") from None
    if not 0 <= first <= len(memory):
        raise ArgumentError("dem.tail: first: %d is given, must be from 0 to %d, the numbers of this contact history" % (
            first, len(memory)))
    kind = _history(len(memory) - first, max(0, getattr(memory, "vectors", 5) - (first + 2)//3))
    part = kind.from_address(ctypes.addressof(memory) + first*ctypes.sizeof(Real))
    part.owner = memory
    return part


@functools.lru_cache(None)
def _rows_of(name):
    """Of an array of all bodies: name of the pointer, type of its numbers, place in the struct, width (0: one axis)."""
    kind = Bodies.kinds[name]
    return "_" + name, kind.kind, getattr(Bodies, "_" + name).offset, kind.shape[1] if len(kind.shape) > 1 else 0


_SETTERS = {"groups": "call world.bodies_group_set(selection, group, member)",
            "orientations": "call body.set(orientation=...) for each body", "masses": "a mass follows from the density of the material "
            "and the radius; call body.radius_set(radius)"}
_SETTERS.update(dict.fromkeys(("radius", "radii", "radiuses"), "call body.radius_set(radius) for each body"))
_SETTERS.update((one, "write world.bodies.%s = array, or call body.set(%s=...) for one body" % (many, one)) for one, many in (
    ("position", "positions"), ("velocity", "velocities"), ("spin", "spins")))


def _not_finite(row, numbers, more=""):
    """The exception for a row of an array of all bodies."""
    return ArgumentError("%s is (%s), must be finite%s; check what it was computed from; nothing was changed" % (
        row, ", ".join("%g" % number for number in numbers), more))


class Rows:
    """The arrays of all bodies of a world. Row i belongs to the body world.bodies[i] in all of them, and keeps it while the
    world runs: rows are in the order of the slots of bodies, which is the order of adding. A body that is added after
    another one was removed may take its slot, and then its place.

    Each use of an array is a copy of what the world has then, read-only, as an Array: positions (N x 4: x, y, z, radius, m), velocities
    (N x 4: x, y, z, 0, m/s), spins (rad/s), forces (N, without gravity), torques (N m), masses (kg), slots, materials,
    orientations (N x 4: w, x, y, z), shapes, reals (N x real_count), rates, groups. world.bodies_memory has the arrays of
    dem.h without a copy, in an order that changes while the world runs.

    An assignment sets all rows: world.bodies.velocities = array of shape (N, 3); so do positions, spins and reals."""
    __slots__ = ("_world",)

    def __init__(self, world):
        object.__setattr__(self, "_world", world)

    def __getattr__(self, name):
        if name[:1] == "_":
            raise AttributeError("Rows has no attribute %r" % name)
        raise NoFieldError("world.bodies has no %r%s" % (name, "; radii are column 3 of world.bodies.positions" if name in (
            "radius", "radii") else _near(name, [word for word in dir(type(self)) if word[0] != "_"])))

    def _struct(self):
        return _lib.dem_bodies_get(self._world._c)

    @property
    def count(self):
        """The number of bodies."""
        return self._struct().count

    @property
    def real_count(self):
        """Numbers per body (World(body_reals=...))."""
        return self._struct().real_count

    def _get(self, name):
        raw, item, offset, axis = _rows_of(name)
        at = self._world._c
        found = _lib.dem_bodies_get(at)
        count = found.count
        pointer = getattr(found, raw)
        if not pointer or not count:                        # memory of removed bodies may be left
            return None
        width = found.real_count if axis == "real_count" else axis
        array = (item*(count*(width or 1)))()
        if "dempy_rows" in _lib.__dict__:
            result = _lib.dempy_rows(at, offset, (width or 1)*ctypes.sizeof(item), count, ctypes.addressof(array))
            if result:
                raise MemoryError("World.bodies.%s: out of memory" % name)
        else:
            rows = sorted(range(count), key=found.slots.__getitem__)
            width = width or 1
            for i, row in enumerate(rows):
                array[width*i:width*i + width] = pointer[width*row:width*row + width]
        view = memoryview(array).cast("B")
        return Array(view.cast(item._type_, (count, width) if axis else (count,)).toreadonly(), name)

    def _all(self):
        """The ids of all bodies."""
        world, context = self._world, self._world._context
        counts = _lib.dem_body_counts_get(world._c)
        key = world._at, bytes(counts)
        if context.ids is None or context.ids[0] != key:
            count = self.count
            ids = (Body*count)()
            if count:
                if "dempy_ids" in _lib.__dict__:
                    if _lib.dempy_ids(world._at, count, ctypes.addressof(ids)):
                        raise MemoryError("World.bodies: out of memory")
                else:
                    slots = self._struct().slots
                    for i, row in enumerate(sorted(range(count), key=slots.__getitem__)):
                        ids[i] = _lib.dem_body_id_get(world._at, row)
            context.ids = key, ids
        return context.ids[1]

    def __len__(self):
        return self.count

    def __getitem__(self, index):
        ids = self._all()
        if isinstance(index, slice):
            return [Body.from_buffer_copy(item).of(self._world) for item in ids[index]]
        try:
            return ids[index].of(self._world)
        except TypeError:
            raise ArgumentTypeError("World.bodies: %s, the number of a body is wanted" % _given(index)) from None
        except IndexError:
            raise NoSuchError("World.bodies: %s is given, the world has %d bodies" % (index, len(ids))) from None

    def __iter__(self):
        return iter(self[:])

    def to_dict(self):
        """Columns that pandas.DataFrame takes: x, y, z, radius, vx, vy, vz, wx, wy, wz, fx, fy, fz, mass, material, and the
        numbers of bodies by their names."""
        columns = {}
        for name, letters in (("positions", "x y z radius"), ("velocities", "vx vy vz"), ("spins", "wx wy wz"), ("forces", "fx fy fz")):
            rows = self._get(name).tolist() if self.count else []
            for i, letter in enumerate(letters.split()):
                columns[letter] = [row[i] for row in rows]
        columns.update((name, self._get(array).tolist() if self.count else []) for name, array in (("mass", "masses"), ("material", "materials")))
        names = (self._world.desc.body_reals or "").split()
        rows = self._get("reals").tolist() if names and self.count else []
        columns.update((name, [row[i] for row in rows]) for i, name in enumerate(names))
        return columns

    def _in_memory(self, array, width):
        """Rows in the order of world.bodies, as an array in the order of dem.h."""
        found, moved = self._struct(), type(array)()
        for i, row in enumerate(sorted(range(found.count), key=found.slots.__getitem__)):
            mine = moved[width*row:width*row + width] = array[width*i:width*i + width]
            if not all(map(math.isfinite, mine)):
                raise _not_finite("World.bodies.reals[%d]" % i, mine)
        return moved

    def __setattr__(self, name, value):
        if name == "reals":
            return self._world.bodies_reals_set(value)
        if name not in ("positions", "velocities", "spins"):
            raise FieldError("World.bodies.%s cannot be set; %s" % (name, _SETTERS.get(name) or "positions, velocities, spins and reals can%s" % (
                _near(name, ("positions", "velocities", "spins", "radii", "reals")) if name not in Bodies.kinds else "")))
        ids = self._all()
        array = _array_of(value, Real, "World.bodies.%s" % name, 3, len(ids))
        if "dempy_put" in _lib.__dict__:
            result = _lib.dempy_put(self._world._c, len(ids), ctypes.addressof(ids), *[
                ctypes.addressof(array) if name == field else None for field in ("positions", "velocities", "spins")])
            if result < 0:
                i = -1 - result
                raise _not_finite("World.bodies.%s[%d]" % (name, i), array[3*i:3*i + 3], " and at most 1e15")
            self._world._ok(result)
        else:
            for i, body in enumerate(ids):
                body.of(self._world).set(**{{"positions": "position", "velocities": "velocity", "spins": "spin"}[name]:
                                            array[3*i:3*i + 3]})

    def __repr__(self):
        return "<%d bodies: %s>" % (self.count, ", ".join(name for name in Bodies.kinds if name not in ("count", "real_count")))


class Structs:
    """Structs that dem.h has filled, such as world.contacts: a sequence, which numpy.asarray takes as a structured array and
    to_dict() as columns."""

    def __init__(self, array):
        self._array = _fixed(array)

    def __len__(self):
        return len(self._array)

    def __reduce_ex__(self, _):
        return _structs_from, (self._array._type_, len(self), bytes(self._array))

    def __eq__(self, other):
        return len(self) == len(other) and all(map(_same, self, other)) if isinstance(other, (Structs, list, tuple)) else NotImplemented

    __hash__ = None

    def __getitem__(self, index):
        try:
            return self._array[index]
        except TypeError:
            raise ArgumentTypeError("%s, the number of an element is wanted" % _given(index)) from None
        except IndexError:
            raise NoSuchError("%s is given, there are %d elements" % (index, len(self._array))) from None

    def __array__(self, dtype=None, copy=None):
        import numpy
        kind = numpy.dtype(self._array._type_)
        array = numpy.frombuffer(self._array, kind) if len(self._array) else numpy.zeros(0, kind)
        return array if dtype is None or dtype == kind else array.astype(dtype)

    def to_dict(self):
        """Columns that pandas.DataFrame takes: a list for each number, such as a, b, point_x, normal_z, overlap."""
        columns = {}

        def add(kind, offset, path):
            for (raw, c), name in zip(kind._fields_, kind.kinds):
                at = offset + getattr(kind, raw).offset
                if isinstance(c, type) and issubclass(c, Struct):
                    add(c, at, path + [name])
                elif c in _NUMBERS:
                    columns["_".join(path + [name])] = [c.from_buffer(self._array, at + i*size).value for i in range(len(self))]
        size = ctypes.sizeof(self._array._type_)
        add(self._array._type_, 0, [])
        return columns

    def __repr__(self):
        return "<%d %s>" % (len(self), self._array._type_.__name__)


def _structs_from(kind, count, data):
    """Structs that were pickled."""
    return Structs(_row(kind, count).from_buffer_copy(data) if count else _row(kind, 0)())


def _row_property(name, doc):
    return property(lambda self: self._get(name), lambda self, value: self.__setattr__(name, value), doc=doc)


class _Compiled(ctypes.CDLL):
    """The functions of a text in C."""

    def __getattr__(self, name):
        try:
            return super().__getattr__(name)
        except AttributeError:
            if name[:1] == "_":
                raise
            raise NoFieldError("dem.compile: the text has no function %r; check its name, and do not declare it static"
                               % name) from None


def compile(source, flags=()):
    """Compiles C functions, such as a contact law, and returns the library: World(law=dem.compile(text).sticky).

    source: the text, or a path that ends with .c. The header dem.h of this module is found by #include "dem.h", and the
    precision is that of this process. flags: more flags of the compiler. The library is kept beside that of dem.h; its name
    contains a digest of the text, the flags, dem.h and the precision, so that a text that has changed is compiled again."""
    if isinstance(flags, str):
        flags = flags.split()
    if not isinstance(source, (str, os.PathLike)):
        raise ArgumentTypeError("dem.compile: source: %s, a text in C or a path is wanted" % _given(source))
    if not isinstance(flags, (list, tuple)) or not all(isinstance(flag, str) for flag in flags):
        raise ArgumentTypeError("dem.compile: flags: %s, a list of texts is wanted" % _given(flags))
    if isinstance(source, os.PathLike) or "\n" not in source and source.endswith(".c"):
        try:
            with open(source) as file:
                source = file.read()
        except OSError as error:
            raise FileError("dem.compile: cannot read %s: %s" % (os.fspath(source), error.strerror)) from None
    header = _header()
    with open(header, "rb") as file:
        text = file.read()
    whole = "#line 1 \"source\"\n" + source + "\n#line 1 \"dem.compile\"\n#include \"dem.h\"\nconst int dempy_real_size = (int)sizeof(dem_real);\n"
    command = os.environ.get("CC", "cc").split() + os.environ.get("DEM_CFLAGS", "-O2").split()
    command += ["-DDEM_REAL=float"] if Real is ctypes.c_float else []
    command += ["-ffp-contract=off", "-Werror=implicit-function-declaration", "-shared", "-fPIC", "-I" + os.path.dirname(header)] + list(flags)
    digest = hashlib.sha256(text + whole.encode() + "\n".join(command + [str(Real), sys.platform, platform.machine()]).encode())
    folder = _folder(header, None)
    path = os.path.join(folder, "law-%s-%s.so" % ("float" if Real is ctypes.c_float else "double", digest.hexdigest()[:16]))
    if not os.path.exists(path):
        if not shutil.which(command[0]):
            raise FileError("dem.compile: the C compiler %r was not found; install one (Debian package gcc), or set CC" % command[0])
        with tempfile.TemporaryDirectory(dir=folder) as work:
            file_c, made = os.path.join(work, "law.c"), os.path.join(work, "law.so")
            with open(file_c, "w") as file:
                file.write(whole)
            result = subprocess.run(command + [file_c, "-o", made, "-lm"], capture_output=True, text=True)
            if result.returncode:
                with open(file_c, "w") as file:             # alone, its end is where the text ends
                    file.write("#line 1 \"source\"\n" + source + "\n")
                alone = subprocess.run(command + ["-fsyntax-only", file_c], capture_output=True, text=True)
                said = (alone if alone.returncode else result).stderr
                raise FormatError("dem.compile: the text does not compile: %s" % said.replace(file_c, "source")[:2000])
            os.replace(made, path)
    library = _Compiled(path)
    size = ctypes.c_int.in_dll(library, "dempy_real_size").value
    if size != ctypes.sizeof(Real):
        raise ArgumentError("dem.compile: the text sets DEM_REAL to a type of %d bytes, this process has reals of %d; leave it out, "
                            "or set the environment variable DEM_REAL before import dem" % (size, ctypes.sizeof(Real)))
    return library


class Page:
    """A replay file, which Jupyter shows inside a notebook: dem.Page("drum.html")."""

    def __init__(self, path, height=560):
        path = os.fsdecode(_text_of(path, "dem.Page: path"))
        try:
            height = _number(height, ctypes.c_int)
        except (TypeError, OverflowError) as error:
            raise _named(error, "dem.Page: height") from None
        if height <= 0:
            raise ArgumentError("dem.Page: height: %d is given, must be > 0" % height)
        try:
            with open(path, "rb") as file:
                found = b'<script type="dem/head">' in file.read(2**20)     # behind the viewer
        except OSError as error:
            raise FileError("dem.Page: cannot read %s: %s" % (path, error.strerror)) from None
        if not found:
            raise FormatError("dem.Page: %s is not a replay of dem.h; world.replay(path) records one" % path)
        self.path, self.height = path, height

    def __repr__(self):
        return "dem.Page(%r)" % self.path

    def _repr_html_(self):
        try:
            with open(self.path, encoding="utf-8") as file:
                text = file.read()
        except OSError as error:
            raise FileError("dem.Page: cannot read %s: %s" % (self.path, error.strerror)) from None
        return '<iframe srcdoc="%s" width="100%%" height="%d" style="border:0"></iframe>' % (
                html.escape(text), self.height)

# ---- enums ---------------------------------------------------------------------------------------


class NormalLaw(enum.IntEnum):
    """The law of the normal force. Here delta is the overlap, m, and v the closing speed, m/s."""
    # F = kn delta^(3/2) + cn delta^(1/4) v [HER82, TSU92]
    HERTZ = 0
    # F = kn delta + cn v. kn is given, or follows from Young's modulus and an impact speed.
    LINEAR = 1
    # [ALK07] eq 2.47: the contact loads along kn delta, unloads and reloads with slope kun, and attracts by at most
    # kad delta. It needs no dashpot.
    HYSTERETIC = 2


class TangentLaw(enum.IntEnum):
    """The law of friction. Every law except "none" limits the force by Coulomb's law."""
    # "spring" if any pair has friction, otherwise "none"
    AUTO = 0
    # no tangential force
    NONE = 1
    # -ct v_t, without history
    VISCOUS = 2
    # [MIL]: -kt (v_t dt) - ct v_t, without history
    STEP = 3
    # [CS79]: -kt xi - ct v_t, where xi is the integral of v_t over the contact
    SPRING = 4
    # [DIR05]: the force grows by increments, with kt of the overlap in the middle of the step
    MINDLIN = 5
    # [THO13]: as "mindlin", but the force is scaled down with kt during unloading
    MINDLIN_RESCALED = 6


class RollingLaw(enum.IntEnum):
    """The law of rolling resistance."""
    # "epsd" if any pair has rolling friction, otherwise "none"
    AUTO = 0
    # no rolling resistance
    NONE = 1
    # [MIL] section 4.5: mu_r R* min(Fn, |w|), with the dimensions as printed there
    STEP = 2
    # [ZHO99]: a moment mu_r R* Fn against the relative spin; at rest any moment up to that
    CONSTANT = 3
    # [AI11]: an elastic-plastic spring and a dashpot, with history
    EPSD = 4


class Tension(enum.IntEnum):
    """The dashpot at the end of a contact, where it would attract."""
    # The dashpot may attract; the restitution is the given one.
    ALLOWED = 0
    # The contact ends at zero force. The restitution becomes higher than the given one: 0.66 gives about 0.69 [SP07].
    CLIPPED = 1
    # The contact ends at zero force and the damping is raised so that the restitution is the given one: the closed
    # form of [SP07] solved for the dashpot, as in [THO13].
    COMPENSATED = 2


class Load(enum.IntEnum):
    """The load L of Coulomb's limit mu L. The choices differ where the normal force has a dashpot."""
    # L is the whole normal force, or 0 while it attracts: Coulomb's law at every instant. In an impact that slides
    # throughout, the impulse of friction is larger than mu times the normal impulse: by 9 % at a restitution of 0.25,
    # by 14 % at 0.1.
    REPULSIVE = 0
    # L is the elastic part of the normal force. In an impact that slides throughout, the impulse of friction is mu
    # times the normal impulse for any restitution, as for rigid bodies.
    ELASTIC = 1
    # L is the magnitude of the normal force, as in LAMMPS, LIGGGHTS and MercuryDPM. The excess is 18 % at a
    # restitution of 0.25 and 28 % at 0.1.
    MAGNITUDE = 2


class Slider(enum.IntEnum):
    """How the tangential spring and dashpot share Coulomb's limit while a contact slides. The force is the same while a
    contact sticks and while it slides steadily. In between, the force differs, and so does the energy that the spring
    holds.
    """
    # Spring and dashpot act in parallel behind one slider. This never creates energy.
    PARALLEL = 0
    # The spring alone takes the whole limit, as in [THO13] and its published impacts. Creates up to 3 % of an
    # impact's energy at a restitution of 0.5 and 15 % at 0.1.
    SPRING = 1
    # The spring takes what the dashpot leaves of the limit, as in LAMMPS, MercuryDPM and MFiX. It stores energy that
    # no slip supplied. Under Hertz's law with a dashpot the result depends on the time step: an oblique impact leaves
    # at 0.247 of its speed at t_c/100, and at 0.221 at t_c/25600 and below.
    REMAINDER = 2


class Convention(enum.IntEnum):
    """Conventions for effective quantities and overlaps."""
    # E*, G*, R*, m* and the overlap as in the contact literature
    STANDARD = 0
    # [MIL] Fig 5.23: E* = E, 8 G, half overlaps between grains, R/2 and m/2 against walls. Only for reproducing that
    # thesis.
    MILL = 1


class Integrator(enum.IntEnum):
    """The scheme of time integration with springs. Impulses have their own, of second order."""
    # second order; the default
    VELOCITY_VERLET = 0
    # first order, gains energy; the scheme named in the text of [MIL]
    FORWARD_EULER = 1
    # first order, bounded error of energy
    SYMPLECTIC_EULER = 2
    # the original Verlet scheme: x(t + dt) = 2 x(t) - x(t - dt) + a dt^2
    POSITION_VERLET = 3
    # velocities at half steps; the same trajectory as velocity Verlet
    LEAPFROG = 4


class Response(enum.IntEnum):
    """How contacts respond."""
    # Soft contacts: forces grow with the overlap, by the laws above. A time step is a fiftieth of a contact time.
    SPRINGS = 0
    # Rigid contacts (non-smooth dynamics): impulses prevent overlap. The laws above do not act; restitution, friction
    # and static friction of the materials do, and cohesion and compliance of pairs. Rolling and spinning friction
    # need Gauss-Seidel; with another solver a step fails. A time step is as long as the flow allows, 1e-3 s for
    # grains of some millimetres.
    IMPULSES = 1


class Cone(enum.IntEnum):
    """The friction law of impulses."""
    # Coulomb's law: sliding contacts stay closed.
    COULOMB = 0
    # The convex relaxation of [TAS10]: a contact that slides at speed v opens by mu v dt.
    CONVEX = 1


class Solver(enum.IntEnum):
    """The iterative solver for impulses. The page docs/impulses.md compares them."""
    # one contact after another: robust, and needs the fewest sweeps; the default
    GAUSS_SEIDEL = 0
    # all contacts at once; for comparison
    JACOBI = 1
    # accelerated projected gradient descent [MAZ15]; for residuals far below the default
    APGD = 2
    # projected gradients with Barzilai-Borwein steps [HEY13]; for residuals far below the default
    SPECTRAL = 3


class Rotation(enum.IntEnum):
    """How the orientations of bodies other than spheres are integrated. Every choice conserves angular momentum to
    round-off in free flight and is of second order in dt under torques. docs/shapes.md compares errors and costs.
    """
    # [SPI24] with conserved angular momentum; the most accurate and the cheapest
    SPIRAL = 0
    # [FIN92], as used by [RUB15]; gains energy, for comparison
    FINCHAM = 1
    # symplectic splitting [DLM97]; the smallest change of energy, the most expensive
    NO_SQUISH = 2


class Overlap(enum.IntEnum):
    """The overlap of two ellipsoids. Scaled about their centres by W0, the two touch in one point. hA and hB are their
    support heights along the normal there.
    """
    # l (1 - W0), where l is the sum of the radii of spheres of equal volume. The force is the gradient of an energy,
    # so built-in laws conserve energy.
    CONSERVATIVE = 0
    # [RUB15] section 3.2: the length inside both ellipsoids of a line through the contact point, there V2 V3
    # (docs/theory_surfaces.md)
    CHORD = 1
    # (hA + hB)(1 - W0), along the normal
    NORMAL = 2


class ClusterContacts(enum.IntEnum):
    """How several contacts between the spheres of two bodies count, if one body is a cluster."""
    # Contacts with similar normals act as one contact. Stiffness and restitution do not depend on the number of
    # spheres that touch [BER23].
    MERGED = 0
    # Each is a contact of its own. The stiffness grows with their number.
    SEPARATE = 1


class Search(enum.IntEnum):
    """The broad phase of contact detection. All choices find the same contacts."""
    # a grid, or a hierarchical grid if radii differ enough; World.report prints the choice
    AUTO = 0
    # every pair; the reference for the others
    ALL_PAIRS = 1
    # a uniform grid of cells
    GRID = 2
    # a linked linear list [ALK07] section 2.3.2: sorted ends of boxes on three axes
    LINKED_LIST = 3
    # a hierarchical grid [OGA12]: each class of radii has its own cells
    HIERARCHICAL = 4
    # bins [MAZ11]: each body is entered in every bin that its box touches
    BINS = 5


class Boundary(enum.IntEnum):
    """The faces of the domain box, per axis: what they do to a body that leaves."""
    # nothing: bodies may leave
    OPEN = 0
    # a body that leaves on one side enters on the other
    PERIODIC = 1
    # A body whose centre leaves is removed in that step and counted as left. Each removal rebuilds the neighbour
    # list, so an outlet is cheaper where many bodies leave one by one.
    OUTFLOW = 2


class SizesKind(enum.IntEnum):
    """The kind of a size distribution. F(r) is the fraction finer than radius r. All are truncated to min <= r <= max
    and scaled to 1.
    """
    # F grows linearly with r
    UNIFORM = 0
    # log-normal, by median and spread
    LOGNORMAL = 1
    # Weibull or Rosin-Rammler: F = 1 - exp(-(r/scale)^modulus)
    WEIBULL = 2
    # the fraction that passes each of `count` sieves
    SIEVE_CURVE = 3
    # normal, by median and deviation
    NORMAL = 4
    # exponential beyond min with mean `scale` (docs/separator.md): F = 1 - exp(-(r - min)/(scale - min))
    EXPONENTIAL = 5


class ClusterMass(enum.IntEnum):
    """How the mass properties of a cluster are found."""
    # volume shared by several spheres counts once, integrated along parallel rays
    UNION = 0
    # every sphere counts in full
    SUM = 1
    # volume, centre and inertia are given
    GIVEN = 2


class MotionKind(enum.IntEnum):
    """The kind of a wall's motion."""
    # at rest
    FIXED = 0
    # with `velocity`
    TRANSLATING = 1
    # at `speed` about `axis` through `point`, right-handed
    ROTATING = 2
    # displaced by velocity/|velocity| amplitude sin(2 pi frequency t + phase), t = time - start. If sin(phase) is not
    # 0, only with a ramp or before the first step: the wall would jump
    OSCILLATING = 3
    # as `function` says
    USER = 4
    # through the poses of `table`, smoothly
    TABLE = 5
    # along `velocity`, to and fro, so that grains bear `load`
    SERVO = 6


class EdgeRule(enum.IntEnum):
    """How the segments of a profile share the force of a grain that touches several."""
    # The profile acts as one surface, however it is divided: a flat one exerts exactly the force of a plane.
    RESOLVED = 0
    # [MIL] Fig 5.19: each segment exerts the force along the normal of its own line times a^2 (3 - 2a), where a is
    # its fraction of the chord inside the grain. Only for spheres and clusters, and without law_range.
    FRACTION = 1


class SieveKind(enum.IntEnum):
    """The kind of a sieve. Spheres and clusters have contact with all sieves, ellipsoids and polyhedra with infinite
    sieves except "reduced", polygons with none. Ellipsoids and, with springs, polyhedra on plates without thickness
    touch facets in their place.
    """
    NONE = 0
    # a square weave of round wires
    WIRES = 1
    # parallel round wires, across `along`
    BARS = 2
    # a plate with square holes
    SQUARE = 3
    # a plate with round holes
    ROUND = 4
    # a plate with slots, longer along `along`
    SLOTS = 5
    # [ALK07] 4.3.3: a plane through which a sphere falls without contact if it is near enough to the middle of a
    # square hole (SieveDesc.model). It is cheaper and never blinds, but the clearance decides what passes.
    REDUCED = 6


class JointKind(enum.IntEnum):
    """Joints connect a body to another body, to a wall or to space. They need "impulses" and "gauss_seidel". After every
    sweep over the contacts all joints are solved together by a direct method; those of closed loops have a softness
    of 1e-6 of the inverse effective mass. The joined points and axes coincide in the middle of the next step, where
    contacts are found, too. Impulses of joints never add energy, for any number of sweeps (docs/impulses.md). Two
    bodies that are joined have no contact with each other unless `collide` is 1.
    """
    NONE = 0
    # a ball joint: keeps `point` of both together
    POINT = 1
    # a hinge or axle: keeps `axis` of both together too
    REVOLUTE = 2


class Motor(enum.IntEnum):
    """The motor of a revolute joint."""
    NONE = 0
    # rotates a against b at `speed`, by at most `torque`
    SPEED = 1
    # exerts `torque` on a, and the opposite on b
    TORQUE = 2


class Severity(enum.IntEnum):
    """How serious a finding of World.check is."""
    # possibly not intended
    NOTE = 1
    # most likely not intended
    WARNING = 2
    # the scene will not run, or makes no sense
    ERROR = 3


class EventKind(enum.IntEnum):
    """What a function of events is called for."""
    # a contact has ended
    END = 0
    # a contact has begun
    BEGIN = 1
    # a contact exists: World.events_open_each
    OPEN = 2


class OutputKind(enum.IntEnum):
    """The action of an output."""
    # calls a function
    CALL = 0
    # World.vtp_write
    VTP = 1
    # World.xyz_write
    XYZ = 2
    # World.contacts_vtp_write
    CONTACTS = 3
    # World.checkpoint_write
    CHECKPOINT = 4
    # appends the time and some values as a line to a CSV file
    CSV = 5
    # World.surfaces_vtp_write
    SURFACES = 6
    # World.walls_vtp_write, from z0 to z1
    WALLS = 7
    # World.bodies_csv_write
    BODIES_CSV = 8
    # World.contacts_csv_write
    CONTACTS_CSV = 9
    # Field.csv_write, of `field`
    FIELD_CSV = 10


class EffectState(enum.IntEnum):
    """The state of an effect."""
    # the scene does not contain it; it costs nothing
    OFF = 0
    # the scene contains it, but it has not happened so far
    IDLE = 1
    ACTIVE = 2


@_struct
class Vec3(Vector):
    """The id of a vec3."""
    c_name = 'dem_vec3'
    rows = [
        ('x', Real, ''),
        ('y', Real, ''),
        ('z', Real, ''),
    ]


@_struct
class Box(Struct):
    """An axis-aligned box from corner lo to corner hi."""
    c_name = 'dem_box'
    rows = [
        ('lo', Vec3, ''),
        ('hi', Vec3, ''),
    ]


@_struct
class Quat(Numbers):
    """A unit quaternion that rotates vectors from the frame of a body into the world frame. w is the scalar part."""
    c_name = 'dem_quat'
    rows = [
        ('w', Real, ''),
        ('x', Real, ''),
        ('y', Real, ''),
        ('z', Real, ''),
    ]


@_struct
class Pose(Struct):
    """Position and motion of a rigid wall. A point with wall coordinates p is at position + rotation p in the world
    frame.
    """
    c_name = 'dem_pose'
    rows = [
        ('position', Vec3, "m, of the origin of the wall's frame"),
        ('rotation', Real*9, '3 x 3 rotation matrix, row by row'),
        ('velocity', Vec3, 'm/s, of `position`'),
        ('spin', Vec3, 'rad/s, about `position`'),
    ]


@_struct
class Material(Id):
    """The id of a material."""
    c_name = 'dem_material'
    rows = [
        ('id', ctypes.c_int32, ''),
    ]

    def set(self, *, density=None, young=None, poisson=None, restitution=None, friction=None,
            friction_static=None, rolling_friction=None, stiffness=None, stiffness_ratio=None,
            stiffness_unloading=None, stiffness_adhesion=None):
        """Changes moduli, restitution and friction of a material, also while the world runs. Its pairs are mixed again,
        except those that World.pair_set has replaced. Contacts keep their history; a chosen time step is chosen
        again. The density must stay the same, because bodies have their masses. A checkpoint that is written
        afterwards can be read only by a world whose material has been changed in the same way.

        Fields that are not given stay as they are.
        density: kg/m3, required, > 0
        young: Pa, required, > 0; may be 0 with impulses, or if a linear or hysteretic law has a stiffness
        poisson: >= 0 and < 0.5: nu; 0 is a physical value
        restitution: Required, > 0 and <= 1: e, speed after a normal impact over speed before it; may be 0 with
            impulses. The hysteretic law takes either this or stiffness_unloading; they are related by e =
            sqrt(kn/kun) for a contact without adhesion.
        friction: sliding friction mu, >= 0
        friction_static: Static friction mu_s, >= friction; 0 means equal to friction. The limit of friction is mu_s
            Fn until the contact slides, then mu Fn until the slip stops or reverses.
        rolling_friction: mu_r, >= 0: the moment is at most mu_r R* Fn
        stiffness: N/m, kn of the linear and hysteretic law; 0 means from young and impact_speed [DIM04]
        stiffness_ratio: kt/kn of these two laws; 0 means 2(1 - nu)/(2 - nu)
        stiffness_unloading: N/m, kun of the hysteretic law, >= stiffness; 0 means from restitution. Needs stiffness.
        stiffness_adhesion: N/m, kad of the hysteretic law, >= 0 (a negative slope in [ALK07]); 0 means no adhesion
        """
        desc = _renamed(lambda: self.desc, 'Material.desc', 'Material.set')
        desc._put({name: value for name, value in (('density', density), ('young', young), ('poisson', poisson),
            ('restitution', restitution), ('friction', friction), ('friction_static', friction_static),
            ('rolling_friction', rolling_friction), ('stiffness', stiffness), ('stiffness_ratio', stiffness_ratio),
            ('stiffness_unloading', stiffness_unloading), ('stiffness_adhesion', stiffness_adhesion),) if value is not
            None}, 'Material.set: ')
        self.world._ok(_lib.dem_material_set(self.world._c, self, desc))

    @property
    def desc(self):
        """Returns the present values of a material.

        Returns: MaterialDesc
        """
        desc = MaterialDesc()
        self.world._ok(_lib.dem_material_get(self.world._c, self, desc))
        self.world._with(desc, 'call Material.set(...), which changes the fields that it is given')
        return desc


@_struct
class Wall(Id):
    """Counts from 1. A wall added after a removal gets an id of a later generation, such as 262145: ids are names, not
    indices.
    """
    c_name = 'dem_wall'
    rows = [
        ('id', ctypes.c_int32, ''),
    ]

    @property
    def reals(self):
        """The numbers (World(body_reals=...)) of a wall, as a copy. Values must be finite. Laws use them from the next
        step on. It is an error if the world has no names of such numbers.

        Returns: Row
        """
        reals = _row(Real, max(self.world._context.reals, 1))()
        self.world._ok(_lib.dem_wall_reals_get(self.world._c, self, ctypes.cast(reals, ctypes.POINTER(Real))))
        return reals

    def reals_set(self, reals):
        """The numbers (World(body_reals=...)) of a wall: sets them. Values must be finite. Laws use them from the next
        step on. It is an error if the world has no names of such numbers.
        """
        reals = _array_of(reals, Real, 'Wall.reals_set: reals', 1, self.world._context.reals)
        self.world._ok(_lib.dem_wall_reals_set(self.world._c, self, reals))

    def motion_set(self, *, kind=0, velocity=None, point=None, axis=None, speed=0, amplitude=0, frequency=0,
            phase=0, start=0, function=None, user=None, ramp=0, load=0, area=0, travel=0, table=None, table_count=0,
            table_repeats=0):
        """Sets the motion of a wall, from its present pose on. Bodies on its rails follow at once.

        kind: one of "fixed", "translating", "rotating", "oscillating", "user", "table", "servo"
        velocity: m/s, of translating walls; of oscillating ones the direction only; of servo walls the direction in
            which they press, and their largest speed
        point, axis: m; point and direction of the axis of rotation, to which WallLoads also refers torques; axis 0
            means along z. Rotating walls need an axis.
        speed: rad/s, of rotating walls
        amplitude: m: of oscillating walls
        frequency: Hz: of oscillating walls
        phase: rad: of oscillating walls
        start: s. Until then rotating, translating and servo walls are at rest. A time in the past means now.
        function: The function of "user". It must not rotate a mesh or profile that spans a period, because the ends
            stay joined to those of its images: use a table.
        ramp: s, >= 0. The speed (translating, rotating), amplitude (oscillating) or load (servo) rises as 3 u^2 - 2
            u^3, u = (time - start)/ramp, to its full value. 0 means at once.
        load: N, of servo walls: the force with which the wall presses the grains along `velocity`. A table replaces
            it: linear between rows, constant after the last. Servo walls whose motions are equal are one piston and
            bear the load together. They need "springs".
        area: m2, >= 0: load is a stress (Pa) on it; 0 means a force (N)
        travel: m, >= 0, of servo walls: largest distance; 0 means no limit
        table: The rows of "table", at least 2. Between rows the pose is a cubic, so that velocity and spin are
            continuous (tangents of the parabola through three rows). The wall is at rest before the first row and
            after the last. With table_repeats = 1 the table starts again after its last row, which should equal the
            first. From row to row the wall rotates by less than pi.
        """
        motion = Motion._of_call('Wall.motion_set', dict(kind=kind, velocity=velocity, point=point, axis=axis,
            speed=speed, amplitude=amplitude, frequency=frequency, phase=phase, start=start, function=function,
            user=user, ramp=ramp, load=load, area=area, travel=travel, table=table, table_count=table_count,
            table_repeats=table_repeats))
        motion = self.world._bound(motion, ('dem_wall_motion_set', self))
        self.world._ok(_lib.dem_wall_motion_set(self.world._c, self, motion))

    def surface_velocity_set(self, velocity):
        """Sets the velocity of the surface of a wall (m/s), for a belt: the wall does not move with it. The velocity is
        in world axes and rotates with the wall from now on. At a contact the surface moves with the part of it across
        the contact normal, so a curved or closed surface moves along itself everywhere, also at rims. 0 stops it.
        """
        self.world._ok(_lib.dem_wall_surface_velocity_set(self.world._c, self, velocity))

    @property
    def surface_velocity(self):
        """Returns the velocity of the surface, in present world axes.

        Returns: Vec3
        """
        velocity = Vec3()
        self.world._ok(_lib.dem_wall_surface_velocity_get(self.world._c, self, velocity))
        self.world._with(velocity, 'call Wall.surface_velocity_set(...), which changes the fields that it is given')
        return velocity

    @property
    def pose(self):
        """Returns the present pose of a wall.

        Returns: Pose
        """
        pose = Pose()
        self.world._ok(_lib.dem_wall_pose_get(self.world._c, self, pose))
        self.world._with(pose, 'call wall.motion_set(...), which moves the wall from there on')
        return pose

    def remove(self):
        """Removes a wall. Ids of other walls stay valid. It is an error if an outlet moves with it."""
        self.world._ok(_lib.dem_wall_remove(self.world._c, self))

    @property
    def loads(self):
        """Returns the loads of a wall.

        Returns: WallLoads
        """
        loads = WallLoads()
        self.world._ok(_lib.dem_wall_loads_get(self.world._c, self, loads))
        self.world._with(loads)
        return loads

    def loads_reset(self):
        """Sets the sums of a wall's loads to 0."""
        self.world._ok(_lib.dem_wall_loads_reset(self.world._c, self))

    def wear(self, coefficient, hardness):
        """Computes the wear of a wall by Archard's law: the worn volume is the work of sliding times a dimensionless
        coefficient, over the hardness (Pa, > 0) of the softer side. coefficient: >= 0, that of Archard (per normal
        force and distance) divided by the coefficient of friction.

        Returns: Wear
        """
        wear = Wear()
        self.world._ok(_lib.dem_wall_wear_get(self.world._c, self, coefficient, hardness, wear))
        self.world._with(wear)
        return wear

    @property
    def wear_facets(self):
        """Returns the work of sliding on each facet (mesh) or segment (profile) of a wall, J, in the order of its
        elements. The work counts for the facet that is nearest to the contact point. It is an error if contacts are
        not recorded.
        """
        capacity = self.world._number(_lib.dem_wall_wear_facets_get(self.world._c, self, None, 0))
        work = _row(ctypes.c_double, max(capacity, 1))()
        count = self.world._number(_lib.dem_wall_wear_facets_get(self.world._c, self, ctypes.cast(work,
            ctypes.POINTER(ctypes.c_double)), capacity))
        array = _row(work._type_, count).from_buffer(work)
        return array

    @property
    def servo(self):
        """Returns the state of a servo wall.

        Returns: Servo
        """
        servo = Servo()
        self.world._ok(_lib.dem_wall_servo_get(self.world._c, self, servo))
        self.world._with(servo)
        return servo

    def loads_csv_write(self, path):
        """Appends the loads of a wall to a CSV file: time (s), force (N), torque (N m), axial torque (N m), power (W),
        number of contacts. Writes the heading first if the file is new or empty.
        """
        self.world._ok(_lib.dem_wall_loads_csv_write(self.world._c, self, _text_of(path,
            'Wall.loads_csv_write: path')))


@_struct
class Field(Id):
    """Counts from 1. A wall added after a removal gets an id of a later generation, such as 262145: ids are names, not
    indices.
    """
    c_name = 'dem_field'
    rows = [
        ('id', ctypes.c_int32, ''),
    ]

    @property
    def data(self):
        """Returns views of the sums of a field.

        Returns: FieldData
        """
        data = FieldData()
        self.world._ok(_lib.dem_field_get(self.world._c, self, data))
        self.world._with(data)
        return data

    def cell(self, i, j, k):
        """Computes the means of the cell (i, j, k), which count from 0.

        Returns: FieldCell
        """
        cell = FieldCell()
        self.world._ok(_lib.dem_field_cell_get(self.world._c, self, i, j, k, cell))
        self.world._with(cell)
        return cell

    def reset(self):
        """Sets the sums of a field, the averages of its bodies and its number of samples to 0; the window of time stays."""
        self.world._ok(_lib.dem_field_reset(self.world._c, self))

    def csv_write(self, path):
        """Writes the cells of a field: centre (m) and what Field.cell returns."""
        self.world._ok(_lib.dem_field_csv_write(self.world._c, self, _text_of(path, 'Field.csv_write: path')))


@_struct
class Group(Id):
    """counts from 1"""
    c_name = 'dem_group'
    rows = [
        ('id', ctypes.c_int32, ''),
    ]


@_struct
class Shape(Id):
    """counts from 1 in World(groups=...)"""
    c_name = 'dem_shape'
    rows = [
        ('id', ctypes.c_int32, ''),
    ]

    @property
    def info(self):
        """Returns the properties of a shape.

        Returns: ShapeInfo
        """
        info = ShapeInfo()
        self.world._ok(_lib.dem_shape_get(self.world._c, self, info))
        self.world._with(info)
        return info


@_struct
class Body(Id):
    """slot counts from 1. A later body in the same slot has another generation."""
    c_name = 'dem_body'
    rows = [
        ('slot', ctypes.c_uint32, ''),
        ('generation', ctypes.c_uint32, ''),
    ]

    def remove(self):
        """Removes a body. Its id becomes invalid."""
        self.world._ok(_lib.dem_body_remove(self.world._c, self))

    @property
    def state(self):
        """Returns the state of a body.

        Returns: BodyState
        """
        state = BodyState()
        self.world._ok(_lib.dem_body_get(self.world._c, self, state))
        self.world._with(state, 'call Body.set(...), which changes the fields that it is given')
        return state

    def set(self, *, position=None, velocity=None, spin=None, fixed=None, orientation=None):
        """Sets position, velocity, spin, orientation and fixed. Start from Body.state. A body on a rail keeps its
        velocity and spin along and about locked axes.

        Fields that are not given stay as they are.
        position: m
        velocity: m/s
        spin: rad/s
        fixed: 1: the body never moves, whatever forces act on it
        orientation: Rotates the frame in which the shape was given into the world. Body.set accepts any length but 0.
            Spheres have one if World(orientations=1).
        """
        state = _renamed(lambda: self.state, 'Body.state', 'Body.set')
        state._put({name: value for name, value in (('position', position), ('velocity', velocity), ('spin', spin),
            ('fixed', fixed), ('orientation', orientation),) if value is not None}, 'Body.set: ')
        state = self.world._bound(state, ('dem_body_set', self))
        self.world._ok(_lib.dem_body_set(self.world._c, self, state))

    def radius_set(self, radius):
        """Sets the radius of a body, m, > 0 (BodyState.radius; all lengths of its shape scale with it). Mass and moments
        of inertia follow from the density of the material. Velocity, spin and contacts with their history stay. The
        next step checks the time step, or chooses it again. The ledger counts the kinetic energy of the new mass as
        `inserted`, and what springs gain as `growth`. See World(growth=...) for radii that change all the time.
        """
        self.world._ok(_lib.dem_body_radius_set(self.world._c, self, radius))

    @property
    def reals(self):
        """The numbers (World(body_reals=...)) of a body, as a copy. Values must be finite. Laws use them from the next
        step on. It is an error if the world has no names of such numbers.

        Returns: Row
        """
        reals = _row(Real, max(self.world._context.reals, 1))()
        self.world._ok(_lib.dem_body_reals_get(self.world._c, self, ctypes.cast(reals, ctypes.POINTER(Real))))
        return reals

    def reals_set(self, reals):
        """The numbers (World(body_reals=...)) of a body: sets them. Values must be finite. Laws use them from the next
        step on. It is an error if the world has no names of such numbers.
        """
        reals = _array_of(reals, Real, 'Body.reals_set: reals', 1, self.world._context.reals)
        self.world._ok(_lib.dem_body_reals_set(self.world._c, self, reals))

    def rail_set(self, *, axes=0, velocity=None, spin=None, wall=None):
        """Puts a body on a rail, changes its rail, or takes it off (axes 0). Its velocity and spin along locked axes
        become the prescribed ones at once. The forces and torques of Body.state include those of the rail.

        axes: 0 to 63: sum of dem.RAIL_ constants; 0 means no rail
        velocity: m/s, along locked axes
        spin: rad/s, about locked axes
        wall: Along and about locked axes the body also follows the pose of this wall, as if it were part of it, so
            any motion of a wall is a path for a body. None means none, as after the removal of the wall.
        """
        desc = RailDesc._of_call('Body.rail_set', dict(axes=axes, velocity=velocity, spin=spin, wall=wall))
        desc = self.world._bound(desc, ('dem_body_rail_set', self))
        self.world._ok(_lib.dem_body_rail_set(self.world._c, self, desc))

    @property
    def reaction(self):
        """Returns the state of a body's rail. It is an error if the body has none.

        Returns: RailState
        """
        state = RailState()
        self.world._ok(_lib.dem_body_reaction_get(self.world._c, self, state))
        self.world._with(state)
        return state

    @property
    def means(self):
        """Returns the averages of a grain. An error if no field averages bodies.

        Returns: BodyMeans
        """
        means = BodyMeans()
        self.world._ok(_lib.dem_body_means_get(self.world._c, self, means))
        self.world._with(means)
        return means


@_struct
class ContactWho(Struct):
    """The two bodies of a contact, for laws that request them by World(law_who=1)."""
    c_name = 'dem_contact_who'
    rows = [
        ('a', Body, "b is the id 0 at a wall; c.wall is then the wall's id"),
        ('b', Body, None),
        ('radius_a', Real,
         'm, of the spheres that touch (member spheres of clusters); of other shapes the bounding radius; 0 '
         'for a wall, except a wall of grains: the radius of its grains'),
        ('radius_b', Real, None),
        ('mass_a', Real, 'kg, of the whole bodies; 0 for a wall'),
        ('mass_b', Real, None),
        ('point', Vec3, 'm, contact point in the world frame; at a wall: on the surface of a'),
        ('time', ctypes.c_double, 's, at the end of the step'),
        ('reals_a', View(Real, '_per_body', const=True),
         'present values of the user-defined numbers of a and of b or the wall, in the order of '
         'World(body_reals=...); empty if World(body_reals=...) names none'),
        ('reals_b', View(Real, '_per_body', const=True), None),
        ('rate_a', View(Real, '_per_body'),
         'The law adds the rates of change of these numbers here, per s. They are 0 when the law is called; '
         'they are empty if reals_a is. If a contact has several contact points (member spheres of clusters, '
         'facets), dem.h multiplies the rates of each by its weight'),
        ('rate_b', View(Real, '_per_body'), None),
    ]


@_struct
class Contact(Struct):
    """All that a contact law sees. Velocities are those of body a relative to body b, or to the surface of the wall, at
    the full step: use them for dashpots and friction. Displacements in the contact history grow by slip_step dt, the
    displacement of the step just taken, so that springs conserve energy as well as the integrator does.
    """
    c_name = 'dem_contact'
    rows = [
        ('overlap', Real, 'm, > 0 in contact; < 0 across a gap (laws with a range only)'),
        ('range', Real, 'm, gap up to which the law is called here (World(law_range=...)); or 0'),
        ('closing_speed', Real, 'm/s, positive while the two approach'),
        ('normal', Vec3, 'unit vector from a to b'),
        ('slip', Vec3, 'm/s, tangential velocity at the contact point, rotation included'),
        ('spin', Vec3, 'rad/s, spin of a minus spin of b'),
        ('slip_step', Vec3, 'm/s, mean of `slip` over the step just taken'),
        ('spin_step', Vec3, 'rad/s, mean of `spin` over the step just taken'),
        ('normal_rate', Vec3, '1/s, mean rate of change of the normal in that step'),
        ('twist', Real, 'rad/s, mean rotation of the contact plane about the normal'),
        ('r_eff', Real, 'm, 1/(1/Ra + 1/Rb), at a wall Ra; other shapes: equivalent radii'),
        ('m_eff', Real,
         'kg, 1/(1/ma + 1/mb), at a wall ma; with bodies other than spheres the mass that a normal force at '
         'the contact point accelerates, rotation included'),
        ('dt', Real, 's, the time step. 0: leave the contact history unchanged'),
        ('kn', Real,
         'built-in law: N/m^(3/2), N s/m^(5/4) (Hertz) or N/m, N s/m (others). At ellipsoids, polyhedra and '
         'polygons kn, cn, kun and kad are multiplied by s, the derivative of the overlap with respect to the '
         'approach, and the ledger divides `elastic` and `sag` by s. The ledger closes if the normal force is '
         'proportional to these; with other forces, for example a constant attraction, only while s is '
         'constant: not at corners and edges.'),
        ('cn', Real, None),
        ('kt', Real, 'built-in law: N/m^(3/2), N s/m^(5/4) (Hertz) or N/m, N s/m (others)'),
        ('ct', Real, None),
        ('kun', Real, 'N/m, unloading of the hysteretic law; otherwise 0'),
        ('friction', Real, 'of the pair of materials'),
        ('friction_static', Real, None),
        ('rolling_friction', Real, None),
        ('spinning_friction', Real, None),
        ('sliding', Real, 'force.sliding of the last step; 0 when the contact begins'),
        ('material_a', ctypes.c_int32, 'ids of materials'),
        ('material_b', ctypes.c_int32, None),
        ('wall', ctypes.c_int32, 'id of the wall; 0: b is a body'),
        ('tension', ctypes.c_int, 'Tension, Load, Slider of the world desc'),
        ('friction_load', ctypes.c_int, None),
        ('slider', ctypes.c_int, None),
        ('who', ContactWho, 'zeros unless World(law_who=1)'),
        ('user', ctypes.c_void_p, 'World(law_user=...)'),
        ('kad', Real, 'coefficients of single laws'),
    ]


@_struct
class ContactEnergy(Struct):
    """The energies of one contact, J. Losses and work are those of the step."""
    c_name = 'dem_contact_energy'
    rows = [
        ('dashpot', Real, 'lost to the normal dashpot'),
        ('sag', Real, 'lost to hysteresis (dt 0: next step)'),
        ('elastic', Real, 'stored in the normal spring now'),
        ('shear_work', Real, 'work done against the tangential force'),
        ('slide', Real, 'lost to sliding'),
        ('shear_stored', Real, 'stored in the tangential spring now'),
        ('roll', Real, 'lost to rolling resistance'),
    ]


@_struct
class ContactForce(Struct):
    """The result of a contact law. All fields are 0 when the law is called."""
    c_name = 'dem_contact_force'
    rows = [
        ('normal', Real, 'N, positive: repulsion'),
        ('tangent', Vec3, 'N, on a at the contact point; b receives the opposite'),
        ('moment', Vec3, 'N m, on a (rolling resistance); b receives the opposite'),
        ('elastic', Real,
         'N, the part of `normal` that the spring exerts. From here to ct: what a normal law passes to the '
         'friction and rolling laws that follow it. A law that calls none of these may leave them at 0.'),
        ('load', Real, "N, >= 0: L of Coulomb's limit mu L"),
        ('slope', Real, 'N/m, d(elastic)/d(overlap): at the present overlap'),
        ('slope_step', Real,
         'N/m, d(elastic)/d(overlap): at the overlap in the middle of that part of the step in which the two '
         'touched. Hysteretic law: kn'),
        ('kt', Real, 'N/m, tangential stiffness: likewise'),
        ('kt_step', Real, None),
        ('ct', Real, 'N s/m, tangential dashpot'),
        ('sliding', Real,
         '1 while the contact slides, otherwise 0. The friction laws set it. If friction_static is larger than'
         ' friction for any pair, contact history keeps it and c.sliding returns it'),
        ('energy', ContactEnergy, 'for the ledger, which cannot know what a law leaves at 0'),
    ]


def _wrap_dem_allocator_alloc_fn(function, context, struct):

    def call(size, user):
        try:
            return function(size)
        except BaseException as error:
            context.fail(error)
    return ctypes.cast(ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p)(call), AllocatorAllocFn.c)


AllocatorAllocFn = Function(_wrap_dem_allocator_alloc_fn, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p)
AllocatorAllocFn.__doc__ = ''


def _wrap_dem_allocator_free_fn(function, context, struct):

    def call(memory, size, user):
        try:
            function(memory, size)
        except BaseException as error:
            context.fail(error)
    return ctypes.cast(ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p)(call), AllocatorFreeFn.c)


AllocatorFreeFn = Function(_wrap_dem_allocator_free_fn, None, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p)
AllocatorFreeFn.__doc__ = ''


@_struct
class Allocator(Struct):
    """Memory functions of a world. Give both or neither (malloc and free). alloc_fn returns None if there is no memory;
    free_fn receives the size that was requested. One world, or one set of slabs, calls them from one thread at a
    time.
    """
    c_name = 'dem_allocator'
    rows = [
        ('alloc_fn', AllocatorAllocFn, ''),
        ('free_fn', AllocatorFreeFn, ''),
        ('user', ctypes.c_void_p, ''),
    ]


@_struct
class ContactRows(Struct):
    """A row of contacts in columns: c.overlap[q] is the overlap of contact q, c.normal[1][q] the y of its normal. The
    fields and their units are those of Contact, then those of ContactForce, which the law must set for every q below
    `count`. Some contacts of a row are not in touch, and the last group is padded: dem.h ignores what the law returns
    for these, and clears their history.
    """
    c_name = 'dem_contact_rows'
    rows = [
        ('count', ctypes.c_int, 'a multiple of DEM_ROW_GROUP'),
        ('memory_count', ctypes.c_int, 'World(law_memory=...)'),
        ('touch', View(Real, 'count', const=True), '1 in contact or within the range of the law, otherwise 0'),
        ('overlap', View(Real, 'count', const=True), ''),
        ('range', View(Real, 'count', const=True), ''),
        ('closing_speed', View(Real, 'count', const=True), ''),
        ('twist', View(Real, 'count', const=True), ''),
        ('sliding', View(Real, 'count', const=True), ''),
        ('normal', View(Real, 'count', const=True, times=3), ''),
        ('slip', View(Real, 'count', const=True, times=3), ''),
        ('spin', View(Real, 'count', const=True, times=3), ''),
        ('slip_step', View(Real, 'count', const=True, times=3), ''),
        ('spin_step', View(Real, 'count', const=True, times=3), ''),
        ('normal_rate', View(Real, 'count', const=True, times=3), ''),
        ('r_eff', View(Real, 'count', const=True), ''),
        ('m_eff', View(Real, 'count', const=True), ''),
        ('kn', View(Real, 'count', const=True), ''),
        ('cn', View(Real, 'count', const=True), ''),
        ('kt', View(Real, 'count', const=True), ''),
        ('ct', View(Real, 'count', const=True), ''),
        ('kun', View(Real, 'count', const=True), ''),
        ('friction', View(Real, 'count', const=True), ''),
        ('friction_static', View(Real, 'count', const=True), ''),
        ('rolling_friction', View(Real, 'count', const=True), ''),
        ('spinning_friction', View(Real, 'count', const=True), ''),
        ('material_a', View(ctypes.c_int32, 'count', const=True), ''),
        ('material_b', View(ctypes.c_int32, 'count', const=True), ''),
        ('kad', View(Real, 'count', const=True), ''),
        ('dt', Real, 's; this and the following are the same for all contacts'),
        ('tension', ctypes.c_int, ''),
        ('friction_load', ctypes.c_int, ''),
        ('slider', ctypes.c_int, ''),
        ('user', ctypes.c_void_p, ''),
        ('memory', View(Real, 'count', times=LAW_MEMORY), 'contact history: memory[k][q]'),
        ('normal_force', View(Real, 'count'), 'slides: force.sliding'),
        ('tangent', View(Real, 'count', times=3), None),
        ('moment', View(Real, 'count', times=3), None),
        ('slides', View(Real, 'count'), None),
        ('energy', View(Real, 'count', times=7),
         'in the order of ContactEnergy; all None if the world keeps no ledger'),
    ]


def _wrap_dem_law_fn(function, context, struct):
    memory_type = _history(context.memory, context.vectors)
    c_of = _read(Contact).from_address
    shown = context.reals and {'_per_body': context.reals}

    def call(c, memory, force):
        try:
            _c = c_of(c)
            if shown:
                _c.__dict__.update(shown)
            _memory = memory_type.from_address(memory) if memory else memory_type()
            _force = ContactForce.from_address(force)
            result = function(_c, _memory, _force)
            if result is not None:
                raise _returned(result, 'law')
            if _refs(_c) > _ONE and _held(_c):
                raise _kept('c', 'law')
            if _refs(_memory) > _ONE and _held(_memory):
                raise _kept('memory', 'law')
            if _refs(_force) > _ONE and _held(_force):
                raise _kept('force', 'law')
        except BaseException as error:
            context.fail(_beyond(error, 'law', memory=memory_type) if type(error) is IndexError else error, 'law')
            Real.from_address(force).value = _NAN
    return ctypes.cast(ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p)(call), LawFn.c)


LawFn = Function(_wrap_dem_law_fn, None, ctypes.POINTER(Contact), ctypes.POINTER(Real), ctypes.POINTER(ContactForce))
LawFn.__doc__ = 'A contact law: computes *force from *c. `memory` is the contact history: World(law_memory=...) reals. They are 0 when a contact begins and last as long as the two touch or, with a range, are nearer than the range. A law with a range decides itself when a bond or bridge begins and ends, and stores that in its history. If c.dt is 0, dem.h only asks for the force: leave `memory` unchanged. The first 3*law_vectors reals are vectors and change sign when a and b are exchanged; put tangential springs there, and scalars after them. A law must use nothing except its arguments and c.user. Several threads call it at once.'


def _wrap_dem_law_rows_fn(function, context, struct):
    rows_of = _read(ContactRows).from_address

    def call(rows):
        try:
            _rows = rows_of(rows)
            result = function(_rows)
            if result is not None:
                raise _returned(result, 'law_rows')
            if _refs(_rows) > _ONE and _held(_rows):
                raise _kept('rows', 'law_rows')
        except BaseException as error:
            context.fail(error, 'law_rows')
    return ctypes.cast(ctypes.CFUNCTYPE(None, ctypes.c_void_p)(call), LawRowsFn.c)


LawRowsFn = Function(_wrap_dem_law_rows_fn, None, ctypes.POINTER(ContactRows))
LawRowsFn.__doc__ = 'A law that computes the forces of a row of contacts: see WorldDesc.law_rows.'


def _wrap_dem_law_rate_fn(function, context, struct):
    rates_type = Real*2
    c_of = _read(Contact).from_address
    shown = context.reals and {'_per_body': context.reals}

    def call(c, rates):
        try:
            _c = c_of(c)
            if shown:
                _c.__dict__.update(shown)
            _rates = rates_type.from_address(rates) if rates else rates_type()
            result = function(_c, _rates)
            if result is not None:
                raise _returned(result, 'law_rate')
            if _refs(_c) > _ONE and _held(_c):
                raise _kept('c', 'law_rate')
            if _refs(_rates) > _ONE and _held(_rates):
                raise _kept('rates', 'law_rate')
        except BaseException as error:
            context.fail(_beyond(error, 'law_rate', rates=rates_type) if type(error) is IndexError else error, 'law_rate')
            Real.from_address(rates).value = _NAN
    return ctypes.cast(ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)(call), LawRateFn.c)


LawRateFn = Function(_wrap_dem_law_rate_fn, None, ctypes.POINTER(Contact), ctypes.POINTER(Real))
LawRateFn.__doc__ = 'For laws that change user-defined numbers (law_who): bounds the time step. rates[0] receives how fast this contact alone makes a number of body a approach that of its partner, rates[1] the same for body b: 1/s, >= 0, the largest of several numbers. Both are 0 when it is called. A step is stable while dt times the sum over the contacts of a body is below 1. In *c only overlap, range, normal, r_eff, m_eff, dt, user, material_a, material_b, wall and `who` (without point and rates; its radii are those of bounding spheres, of a wall 0) are set; velocities and coefficients are 0.'


@_struct
class BodyState(Struct):
    """The state of a body. Body.set uses position, velocity, spin, orientation and fixed and ignores the rest;
    Body.radius_set sets the radius.
    """
    c_name = 'dem_body_state'
    rows = [
        ('position', Vec3, 'm'),
        ('velocity', Vec3, 'm/s'),
        ('spin', Vec3, 'rad/s'),
        ('force', Vec3, 'N: of the last step, without gravity'),
        ('torque', Vec3, 'N m: of the last step, without gravity'),
        ('radius', Real,
         'm. For a body that is not a sphere: the radius of its bounding sphere and the smallest principal '
         'moment.'),
        ('mass', Real,
         'kg. For a body that is not a sphere: the radius of its bounding sphere and the smallest principal '
         'moment.'),
        ('inertia', Real,
         'kg m2. For a body that is not a sphere: the radius of its bounding sphere and the smallest principal'
         ' moment.'),
        ('material', Material, ''),
        ('fixed', ctypes.c_int, '1: the body never moves, whatever forces act on it'),
        ('orientation', Quat,
         'Rotates the frame in which the shape was given into the world. Body.set accepts any length but 0. '
         'Spheres have one if World(orientations=1).'),
        ('shape', Shape, 'id 0 for a sphere'),
        ('moments', Vec3, 'kg m2, about the principal axes'),
        ('reals', View(Real, '_per_body', const=True),
         'World(body_reals=...), valid until the next step; empty: none'),
    ]


def _wrap_dem_reals_fn(function, context, struct):
    reals_type = Real*context.reals
    rates_type = _row_read(Real, context.reals)
    body_of = _read(BodyState).from_address
    shown = context.reals and {'_per_body': context.reals}

    def call(reals, rates, body, id, time, dt, user):
        try:
            _reals = reals_type.from_address(reals) if reals else reals_type()
            _rates = rates_type.from_address(rates) if rates else rates_type()
            _body = body_of(body)
            if shown:
                _body.__dict__.update(shown)
            result = function(_reals, _rates, _body, id, time, dt)
            if result is not None:
                raise _returned(result, 'reals')
            if _refs(_reals) > _ONE and _held(_reals):
                raise _kept('reals', 'reals')
            if _refs(_rates) > _ONE and _held(_rates):
                raise _kept('rates', 'reals')
            if _refs(_body) > _ONE and _held(_body):
                raise _kept('body', 'reals')
        except BaseException as error:
            context.fail(_beyond(error, 'reals', reals=reals_type, rates=rates_type) if type(error) is IndexError else error, 'reals')
            Real.from_address(reals).value = _NAN
    return ctypes.cast(ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p, Body, ctypes.c_double, Real, ctypes.c_void_p)(call), RealsFn.c)


RealsFn = Function(_wrap_dem_reals_fn, None, ctypes.POINTER(Real), ctypes.POINTER(Real), ctypes.POINTER(BodyState), Body, ctypes.c_double, Real, ctypes.c_void_p)
RealsFn.__doc__ = "Advances the user-defined numbers of a body by one step, in place: `reals` has as many entries as World(body_reals=...) has names. rates: per second, the sum of what the law added for all contacts of the body. *body is its state at the end of the step, at `time` (s); dt: s. Without this function dem.h takes Euler's step, reals += rates dt, which is stable for dt below 2 over the fastest rate of decay. It is called once per body and step, from several threads."


def _wrap_dem_growth_fn(function, context, struct):
    body_of = _read(BodyState).from_address
    shown = context.reals and {'_per_body': context.reals}

    def call(body, id, time, user):
        try:
            _body = body_of(body)
            if shown:
                _body.__dict__.update(shown)
            result = _real_from(function(_body, id, time), 'growth')
            if _refs(_body) > _ONE and _held(_body):
                raise _kept('body', 'growth')
            return result
        except BaseException as error:
            context.fail(error)
            return _NAN
    return ctypes.cast(ctypes.CFUNCTYPE(Real, ctypes.c_void_p, Body, ctypes.c_double, ctypes.c_void_p)(call), GrowthFn.c)


GrowthFn = Function(_wrap_dem_growth_fn, Real, ctypes.POINTER(BodyState), Body, ctypes.c_double, ctypes.c_void_p)
GrowthFn.__doc__ = 'Returns the rate of the radius of a body, m/s (World(growth=...)): > 0 grows, < 0 wears. *body is its state at `time` (s). Slabs call it from several threads.'


ForceFn = Function(None, ctypes.c_void_p)
ForceFn.__doc__ = 'A force field: returns the force (N) on a body with this position (m), velocity (m/s), radius (m) and mass (kg) at a time (s). With impulses position, velocity and time are those of the middle of the coming step. It is called once per body and step, and again whenever forces are computed without a step (after a change of the scene, by World.contacts_each, by the report), from several threads.'


def _wrap_dem_body_force_fn(function, context, struct):
    body_of = _read(BodyState).from_address
    shown = context.reals and {'_per_body': context.reals}

    def call(body, id, time, force, torque, user):
        try:
            _body = body_of(body)
            if shown:
                _body.__dict__.update(shown)
            _force = Vec3.from_address(force)
            _torque = Vec3.from_address(torque)
            result = function(_body, id, time, _force, _torque)
            if result is not None:
                raise _returned(result, 'body_force')
            if _refs(_body) > _ONE and _held(_body):
                raise _kept('body', 'body_force')
            if _refs(_force) > _ONE and _held(_force):
                raise _kept('force', 'body_force')
            if _refs(_torque) > _ONE and _held(_torque):
                raise _kept('torque', 'body_force')
        except BaseException as error:
            context.fail(error, 'body_force')
            Real.from_address(force).value = _NAN
    return ctypes.cast(ctypes.CFUNCTYPE(None, ctypes.c_void_p, Body, ctypes.c_double, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p)(call), BodyForceFn.c)


BodyForceFn = Function(_wrap_dem_body_force_fn, None, ctypes.POINTER(BodyState), Body, ctypes.c_double, ctypes.POINTER(Vec3), ctypes.POINTER(Vec3), ctypes.c_void_p)
BodyForceFn.__doc__ = 'A force field that sees the whole body and may exert a torque. It adds to *force (N) and *torque (N m, about the centre of mass, in the world frame), which are 0 when it is called. *body is the state as Body.state returns it; spheres have an orientation only with World(orientations=...). time: s. id: the body, to find your own data by its slot. Otherwise as ForceFn.'


@_struct
class WorldDesc(Struct):
    """The description of a world. dem.world_create_error checks it."""
    c_name = 'dem_world_desc'
    uses = {'thickness': (('planar', True),), 'normal_law': (('response', ('springs',)),), 'tangent_law':
            (('response', ('springs',)), ('law', False)), 'rolling_law': (('response', ('springs',)), ('law',
            False)), 'tension': (('response', ('springs',)),), 'friction_load': (('response', ('springs',)),),
            'slider': (('response', ('springs',)),), 'convention': (('response', ('springs',)),), 'law_memory':
            (('law', True),), 'law_stiffness': (('law', True),), 'growth_interval': (('growth', True),), 'cone':
            (('response', ('impulses',)),), 'solver': (('response', ('impulses',)),), 'sweeps': (('response',
            ('impulses',)),), 'tolerance': (('response', ('impulses',)),), 'cold_start': (('response',
            ('impulses',)),), 'unsolved_stops': (('response', ('impulses',)),)}
    defaults = {'thickness': 1}
    rows = [
        ('gravity', Vec3, 'm/s2'),
        ('domain', Box,
         'm. Required on axes whose boundary is periodic or outflow, not needed on open axes. A periodic axis '
         'must be at least as long as four of the largest radii, two skins and two ranges of the law.'),
        ('boundary', Choices(Boundary, 3), 'of the faces on the axes x, y and z'),
        ('planar', ctypes.c_int,
         '1 makes the world two-dimensional: bodies are discs and polygons that move in the plane z = 0 and '
         'rotate about z only. The z component of gravity is ignored.'),
        ('thickness', Real, 'm, of discs and polygons along z; 0 means 1 m'),
        ('normal_law', NormalLaw, ''),
        ('tangent_law', TangentLaw, ''),
        ('rolling_law', RollingLaw, ''),
        ('tension', Tension, ''),
        ('friction_load', Load, ''),
        ('slider', Slider, ''),
        ('convention', Convention, ''),
        ('law', LawFn, 'replaces the normal, tangential and rolling law; None means the laws above'),
        ('law_rows', LawRowsFn,
         'The same law for rows of contacts of spheres, which is faster: DEM_LAW_ROWS defines it. It must '
         'return what law returns; dem.h uses whichever suits. It needs law. None means that law is called for'
         ' each contact, as it always is with law_who.'),
        ('law_user', ctypes.c_void_p, 'passed to law as c.user'),
        ('law_memory', ctypes.c_int, 'reals of contact history per contact, 0 to 16'),
        ('law_memory_names', str,
         'Names of these reals for World.contacts_vtp_write, written as in body_reals. None means memory0, '
         'memory1 and so on.'),
        ('law_vectors', ctypes.c_int, 'leading triples of them that are vectors, 0 to law_memory/3'),
        ('law_stiffness', Real,
         'N/m, the largest stiffness of law; limits the time step. 0 means the stiffness of the built-in law.'),
        ('law_range', Real,
         'm, >= 0. law is also called for two bodies that do not touch while their gap is below law_range + '
         'law_range_radii (Ra + Rb), with c.overlap < 0. A wall counts with radius 0, an ellipsoid with its '
         'bounding sphere. Built-in laws that it calls need overlap > 0. 0 means no range. With both 0, law is'
         ' called in contact only, at no extra cost.'),
        ('law_range_radii', Real, '>= 0; see law_range; 0 means no such range'),
        ('law_who', ctypes.c_int, '1 fills in c.who: ids, radii, masses, contact point, time'),
        ('law_rate', LawRateFn,
         'Returns how fast law changes numbers on bodies; limits the time step. It needs law, law_who and '
         'body_reals. It is called before the first step and at least once in eight steps. A given dt above '
         'the stable limit is an error; a chosen dt is at most half of it. None means that these rates do not '
         'limit dt.'),
        ('body_reals', str,
         'Names of numbers that every body and wall carries, such as "temperature charge": at most 8 words of '
         'up to 23 letters, digits and _. Files use these names. The numbers begin as 0. With law_who, law '
         'reads them and returns their rates (per s). None means no numbers.'),
        ('body_reals_fn', RealsFn,
         'Updates the numbers of a body after each step. None means that each grows by rate dt. Numbers of '
         'walls stay as set; WallLoads sums what they would gain.'),
        ('body_reals_user', ctypes.c_void_p, 'passed to body_reals_fn'),
        ('growth', GrowthFn,
         'Returns the rate of the radius of a body, m/s: > 0 grows, < 0 wears. Mass follows at constant '
         'density, velocity and contact history stay. Each change of radii costs a new list and another '
         'computation of forces. None means constant radii; see Body.radius_set.'),
        ('growth_user', ctypes.c_void_p, 'passed to growth'),
        ('growth_interval', Real,
         's, between two changes of radii; 0 means every step. A body that was added within an interval grows '
         'for all of it. In single precision changes below 6e-8 of a radius are lost: take a longer interval'),
        ('groups', str,
         'Names of sets of bodies, such as "coarse tracer": at most 32 words of up to 23 letters, digits and '
         '_. A body belongs to none until World.bodies_group_set. None means no groups.'),
        ('force', ForceFn, 'force on a body; None means none'),
        ('body_force', BodyForceFn, 'force and torque on a body; None means none'),
        ('force_user', ctypes.c_void_p, 'passed to both'),
        ('integrator', Integrator, ''),
        ('dt', Real, 's, the time step; 0 means chosen from the scene, see World.step_advice'),
        ('allow_large_dt', ctypes.c_int,
         '1 allows dt above the stable limit, to show what happens then. It switches off all checks of the '
         'step: of contacts, speeds, walls and law_rate; a chosen dt is not shortened either.'),
        ('impact_speed', Real,
         'm/s, typical impact speed. The time step and, in the linear and hysteretic law, a stiffness from '
         "Young's modulus depend on it. 0 means the largest speed expected from grains, walls and height of "
         'fall for the time step, and 1 m/s for the stiffness.'),
        ('response', Response,
         '"impulses" needs dt > 0 and law None. Its steps are of second order (docs/impulses.md) for either '
         'value of integrator that it accepts, 0 and "symplectic_euler". law_range (m) is then the gap below '
         'which contacts are solved. If it is 0, dem.h takes three times the distance that the fastest point '
         'of a body or wall moves in a step, at most the largest radius R and at least 0.01 R. On a periodic '
         'axis of length P it is at most the larger of 0.1 R and 0.8 (P/2 - 2 R - skin), with skin 0 unless '
         'you set it. The fields that follow apply to impulses only.'),
        ('cone', Cone, ''),
        ('solver', Solver, ''),
        ('sweeps', ctypes.c_int, 'most sweeps over all contacts in a step; 0 means 200'),
        ('tolerance', Real,
         'm/s. The sweeps end when no contact changes its velocity by more in one sweep. 0 means when the root'
         ' mean square change is below 0.05 g dt plus 1e-5 of the largest speed, and the largest change is '
         'below 30 times that. Where polyhedra lie on faces, and in towers of more than three bodies, the root'
         ' mean square must also fall to a tenth of that and to half of its first value, or to 1e-5 of that '
         '(single precision: 3e-4).'),
        ('cold_start', ctypes.c_int, '1 begins with zero impulses, not those of the last step'),
        ('unsolved_stops', ctypes.c_int,
         '1 ends the run with StoppedError after a step whose sweeps did not reach the tolerance. With 0 it '
         'continues; World.counters, the report and World.progress_print count such steps.'),
        ('search', Search, ''),
        ('skin', Real,
         'm, margin of the neighbour list; 0 means chosen for speed; < 0 means none: the list is rebuilt in '
         'every step.'),
        ('rotation', Rotation, ''),
        ('ellipsoid_overlap', Overlap, ''),
        ('cluster_contacts', ClusterContacts, ''),
        ('orientations', ctypes.c_int, '1 follows the orientations of spheres too'),
        ('overlap_stop', Real,
         '0 to 1, in radii (see Counters.overlap_max): a step after which an overlap is larger ends the run '
         'with StoppedError, because grains are jammed or too soft. 0 means off. The report and '
         'World.progress_print name an overlap above 0.05.'),
        ('ledger', ctypes.c_int, '1 accounts for energy, see World.ledger'),
        ('threads', ctypes.c_int,
         'Largest number of threads, 0 to 64; 0 means as many as OpenMP offers, at most 64. Fewer are used '
         'while that is faster; results are the same.'),
        ('allocator', Allocator, 'memory functions; 0 means malloc and free'),
    ]


@_struct
class MaterialDesc(Struct):
    """A material. Moduli, stiffnesses and the density may be at most 1e30 (SI), friction coefficients at most 1e9."""
    c_name = 'dem_material_desc'
    required = ('density',)
    rows = [
        ('density', Real, 'kg/m3, required, > 0'),
        ('young', Real, 'Pa, required, > 0; may be 0 with impulses, or if a linear or hysteretic law has a stiffness'),
        ('poisson', Real, '>= 0 and < 0.5: nu; 0 is a physical value'),
        ('restitution', Real,
         'Required, > 0 and <= 1: e, speed after a normal impact over speed before it; may be 0 with impulses.'
         ' The hysteretic law takes either this or stiffness_unloading; they are related by e = sqrt(kn/kun) '
         'for a contact without adhesion.'),
        ('friction', Real, 'sliding friction mu, >= 0'),
        ('friction_static', Real,
         'Static friction mu_s, >= friction; 0 means equal to friction. The limit of friction is mu_s Fn until'
         ' the contact slides, then mu Fn until the slip stops or reverses.'),
        ('rolling_friction', Real, 'mu_r, >= 0: the moment is at most mu_r R* Fn'),
        ('stiffness', Real, 'N/m, kn of the linear and hysteretic law; 0 means from young and impact_speed [DIM04]'),
        ('stiffness_ratio', Real, 'kt/kn of these two laws; 0 means 2(1 - nu)/(2 - nu)'),
        ('stiffness_unloading', Real,
         'N/m, kun of the hysteretic law, >= stiffness; 0 means from restitution. Needs stiffness.'),
        ('stiffness_adhesion', Real,
         'N/m, kad of the hysteretic law, >= 0 (a negative slope in [ALK07]); 0 means no adhesion'),
    ]


@_struct
class Pair(Struct):
    """The contact properties of two materials. Unless World.pair_set sets them, they are mixed from the materials, for
    walls as for grains:
    - restitution, the three friction coefficients and stiffness_adhesion by the geometric mean: a coefficient that is
        0 in one of the two is 0 in the pair (friction_static 0 means friction);
    - moduli in series as for Hertz, 1/E* = sum (1 - nu^2)/E and 1/G* = sum (2 - nu)/G;
    - stiffness by the mean 2 ka kb/(ka + kb) if both give one; otherwise it follows from E*, or is the given one if
        E* is unknown because a material has no young;
    - stiffness_ratio by the geometric mean if both give one, otherwise from the mean nu.
    """
    c_name = 'dem_pair'
    rows = [
        ('young_eff', Real, 'Pa, E*, > 0; may be 0 where `young` may'),
        ('shear_eff', Real, 'Pa, G*'),
        ('restitution', Real, '> 0 and <= 1: e; may be 0 with impulses'),
        ('friction', Real, 'sliding friction mu, >= 0'),
        ('friction_static', Real,
         'mu_s, >= friction; 0 means equal to friction, also when friction changes. Mixed: 0 if both materials'
         ' leave it 0.'),
        ('rolling_friction', Real, 'mu_r: the moment is at most mu_r R* Fn'),
        ('stiffness', Real, 'N/m, linear and hysteretic law; 0 means from E* and impact_speed for each pair of radii'),
        ('stiffness_ratio', Real, 'kt/kn, linear and hysteretic law'),
        ('tangent_damping', Real, 'factor on the tangential dashpot, >= 0; mixed: 1'),
        ('normal_damping', Real,
         'N s/m, the normal dashpot of the linear and hysteretic law for all masses; 0 means from restitution '
         '(linear) or none (hysteretic)'),
        ('spinning_friction', Real,
         'mu_spin, >= 0: twisting friction, a moment about the normal up to mu_spin R* Fn; 0 when mixed. With '
         'springs: dem.law_twist.'),
        ('cohesion', Real,
         'N, >= 0: attractive force between bodies in contact. It holds until the gap exceeds 1e-3 of the '
         'smaller radius.'),
        ('compliance', Real,
         'm/N, >= 0: a spring of stiffness 1/compliance, evaluated at the end of the step. It is stable for '
         'any value; oscillations that the step does not resolve are damped.'),
        ('stiffness_adhesion', Real, 'N/m, kad of the hysteretic law; its kun is stiffness/restitution^2'),
        ('ignored', ctypes.c_int32,
         '1: bodies and walls of these materials pass through each other. They make no contacts, and laws that'
         ' act at a distance are not called for them. The energy of springs that are in contact when this is '
         'set goes to the residual of the ledger. Mixed: 0.'),
    ]


@_struct
class Coefficients(Struct):
    """The coefficients of the built-in laws for two spheres."""
    c_name = 'dem_coefficients'
    rows = [
        ('r_eff', Real, 'm: effective radius and mass'),
        ('m_eff', Real, 'kg: effective radius and mass'),
        ('kn', Real, 'see Contact: kn d^(3/2) + cn d^(1/4) v or kn d + cn v'),
        ('cn', Real, None),
        ('kt', Real, None),
        ('ct', Real, None),
        ('kun', Real, 'N/m, hysteretic law; otherwise 0'),
        ('damping_ratio', Real, 'beta = -ln e / sqrt(pi^2 + ln^2 e); larger with "compensated"; 0 with impulses'),
        ('contact_time', Real, 's, at the impact speed; hysteretic law: [ALK07] eq 2.45'),
        ('kad', Real, 'kad'),
    ]


def _wrap_dem_inside_fn(function, context, struct):

    def call(centre, radius, user):
        try:
            result = int(bool(function(centre, radius)) or context.raised is not None)
            return result
        except BaseException as error:
            context.fail(error)
            return 1
    return ctypes.cast(ctypes.CFUNCTYPE(ctypes.c_int, Vec3, Real, ctypes.c_void_p)(call), InsideFn.c)


InsideFn = Function(_wrap_dem_inside_fn, ctypes.c_int, Vec3, Real, ctypes.c_void_p)
InsideFn.__doc__ = 'Returns nonzero if a body with this bounding radius (m) may have its centre here.'


@_struct
class Region(Struct):
    """A region for new bodies."""
    c_name = 'dem_region'
    required = ('box',)
    rows = [
        ('box', Box,
         'm, required. Bodies lie wholly inside. If the box spans the domain on a periodic axis, it has no '
         'faces there and centres may be anywhere.'),
        ('cylinder', ctypes.c_int,
         "'x', 'y' or 'z' restricts the region to the cylinder inscribed in the box along that axis, elliptic "
         'if the box is not square. Centres then lie in an ellipse whose half axes are smaller by the radius. '
         '0 means the whole box.'),
        ('inside', InsideFn, 'restricts the region further; None means no restriction'),
        ('user', ctypes.c_void_p, 'passed to inside'),
    ]


@_struct
class Sizes(Struct):
    """A size distribution, by radius."""
    c_name = 'dem_sizes'
    uses = {'median': (('kind', ('lognormal', 'normal')),), 'spread': (('kind', ('lognormal',)),), 'scale':
            (('kind', ('weibull', 'exponential')),), 'modulus': (('kind', ('weibull',)),), 'radius': (('kind',
            ('sieve_curve',)),), 'passing': (('kind', ('sieve_curve',)),), 'deviation': (('kind', ('normal',)),)}
    counts = {'count': (('radius', 1), ('passing', 1))}
    rows = [
        ('kind', SizesKind, ''),
        ('by_count', ctypes.c_int, '1: F is a fraction of the number; 0 means of the mass'),
        ('min', Real,
         'm, 1e-15 <= min <= max < 1e15. 0 means the default of the kind. Log-normal: the median times exp(-6 '
         'spread) and exp(6 spread); normal: 6 deviations from the median, min at least 1e-3 of the median; '
         'sieve curve: its ends; Weibull and exponential: max where F = 1 - 1e-9. The others are required: min'
         ' of Weibull and exponential, both of uniform.'),
        ('max', Real, None),
        ('median', Real, 'm, log-normal and normal, > 0'),
        ('spread', ctypes.c_double, 'log-normal, > 0 and < 10: standard deviation of ln r'),
        ('scale', Real, 'm, > 0: of Weibull; exponential: the mean, > min'),
        ('modulus', ctypes.c_double, 'Weibull, > 0.05 and < 1000'),
        ('count', ctypes.c_int, 'number of sieves, 2 to 32'),
        ('radius', Real*SIEVES, 'm, half the apertures, > 0, ascending'),
        ('passing', ctypes.c_double*SIEVES,
         'Fraction that passes each sieve, ascending, the last 1. F is linear between two sieves; grains that '
         'pass the first have its radius.'),
        ('deviation', Real, 'm, normal, > 0: standard deviation'),
    ]


@_struct
class Bodies(Struct):
    """The arrays of all bodies. Their order changes when the neighbour list is rebuilt; slots identify the bodies.
    Pointers are valid until the next step or change.
    """
    c_name = 'dem_bodies'
    rows = [
        ('count', ctypes.c_int, ''),
        ('positions', View(Real, 'count', 4, const=True), 'count x 4: x, y, z [m], (bounding) radius [m]'),
        ('velocities', View(Real, 'count', 4, const=True), 'count x 4: x, y, z [m/s], 0'),
        ('spins', View(Real, 'count', 4, const=True), 'count x 4: x, y, z [rad/s], 0'),
        ('forces', View(Real, 'count', 4, const=True), 'count x 4: x, y, z [N], 0; gravity is not included'),
        ('torques', View(Real, 'count', 4, const=True), 'count x 4: x, y, z [N m], 0'),
        ('masses', View(Real, 'count', const=True), 'count [kg]'),
        ('slots', View(ctypes.c_uint32, 'count', const=True), 'count: slot of Body less 1; see World.body_id'),
        ('materials', View(ctypes.c_int32, 'count', const=True), 'count: ids of Material'),
        ('orientations', View(Real, 'count', 4, const=True),
         'count x 4: w, x, y, z, from principal axes to the world; None if none is followed'),
        ('shapes', View(ctypes.c_int32, 'count', const=True),
         'count: ids of Shape, 0: sphere; None if orientations is'),
        ('real_count', ctypes.c_int, 'numbers per body (World(body_reals=...))'),
        ('reals', View(Real, 'count', 'real_count', const=True), 'count x real_count; None if there are none'),
        ('rates', View(Real, 'count', 'real_count', const=True),
         'count x real_count, per s, of the last step; None likewise'),
        ('groups', View(ctypes.c_uint32, 'count', const=True),
         'bit id - 1: in that group; None without World(groups=...)'),
    ]


@_struct
class Selection(Struct):
    """Which bodies: those that fulfil every condition. Selection() selects every body."""
    c_name = 'dem_selection'
    counts = {'count': (('bodies', 1),)}
    rows = [
        ('group', Group, 'only members of this group; None means any'),
        ('material', Material, 'only of this material; None means any'),
        ('shape', Shape, 'only of this shape; None means any, spheres included'),
        ('radius_min', Real, 'm, only of these (bounding) radii; max 0 means no limit'),
        ('radius_max', Real, None),
        ('region', View(Region, const=True, one=True),
         'Only bodies whose centre is in this region, or on a periodic axis one of its images. None means '
         'anywhere.'),
        ('count', ctypes.c_int, 'of bodies'),
        ('bodies', View(Body, 'count', const=True),
         'Only these; ids of bodies that are gone do not count. None means any.'),
    ]


@_struct
class BodiesMeans(Struct):
    """Sums and means over selected bodies; zeros if there are none."""
    c_name = 'dem_bodies_means'
    rows = [
        ('bodies', ctypes.c_int, 'their number'),
        ('mass', ctypes.c_double, 'kg, sum'),
        ('centre', ctypes.c_double*3, 'm, of mass; positions in the periodic box'),
        ('velocity', ctypes.c_double*3, 'm/s, of the centre of mass'),
        ('spin', ctypes.c_double*3, 'rad/s: means over bodies'),
        ('radius', ctypes.c_double, 'm: means over bodies'),
        ('force', ctypes.c_double*3, 'N, sum: of the last step, without gravity'),
        ('kinetic', ctypes.c_double, 'J, sums, those of fixed bodies included'),
        ('rotational', ctypes.c_double, None),
    ]


@_struct
class ClusterDesc(Struct):
    """A rigid cluster of spheres, in a frame of your choice."""
    c_name = 'dem_cluster_desc'
    uses = {'rays': (('mass', ('union',)),), 'volume': (('mass', ('given',)),), 'centre': (('mass', ('given',)),),
            'inertia': (('mass', ('given',)),)}
    required = ('positions',)
    counts = {'count': (('positions', 3), ('radii', 1))}
    rows = [
        ('count', ctypes.c_int, 'required, 1 to 1000: number of spheres'),
        ('positions', View(Real, 'count', 3, const=True), 'm, required: count x 3'),
        ('radii', View(Real, const=True), 'm, > 0: one each; None means that all have `radius`'),
        ('radius', Real, 'm, of all spheres if radii is None'),
        ('mass', ClusterMass, ''),
        ('rays', ctypes.c_int,
         '"union": rays per side of the outline, 16 to 4096; 0 means 512. It is an error if rays are more than'
         ' a quarter of the smallest radius apart.'),
        ('volume', Real, 'm3. The rest is for "given".'),
        ('centre', Vec3, 'm, centre of mass'),
        ('inertia', Real*6,
         'm5, moments of inertia about the centre per density: xx, yy, zz, xy, xz, yz. Off-diagonal ones are '
         'elements of the tensor: xy is -(integral of x y).'),
    ]


@_struct
class ShapeInfo(Struct):
    """Properties of a shape."""
    c_name = 'dem_shape_info'
    rows = [
        ('spheres', ctypes.c_int, 'of a cluster; otherwise 0'),
        ('corners', ctypes.c_int, 'of a polyhedron, or the prism of a polygon; otherwise 0'),
        ('faces', ctypes.c_int, None),
        ('volume', Real, 'm3'),
        ('centre', Vec3, 'm, centre of mass in the frame in which the shape was given'),
        ('frame', Quat, 'rotates the principal axes into that frame'),
        ('inertia', Vec3, 'm5, principal moments of inertia per density'),
        ('semi_axes', Vec3, 'm, of the ellipsoid with the same moments'),
        ('radius', Real, 'm, of the smallest sphere about the centre that contains it (a polygon: its prism)'),
        ('pieces', ctypes.c_int, 'of a union; otherwise 0'),
    ]


@_struct
class Ellipsoid(Struct):
    """An ellipsoid outside any world, for analysis. In m; orientation of any length, 0 means none."""
    c_name = 'dem_ellipsoid'
    rows = [
        ('position', Vec3, ''),
        ('semi_axes', Vec3, ''),
        ('orientation', Quat, ''),
    ]


@_struct
class EllipsoidContact(Struct):
    """The contact of two ellipsoids."""
    c_name = 'dem_ellipsoid_contact'
    rows = [
        ('scale', Real, 'W0: scaled by it about their centres, the two touch in one point. < 1 if they overlap.'),
        ('lambda_', Real, '0 to 1, maximises the function of Perram and Wertheim'),
        ('point', Vec3, 'm, of that contact'),
        ('normal', Vec3, 'unit vector from a to b'),
        ('depth_normal', Real, 'm, overlaps as in Overlap; negative if the two are apart, where depth_chord is 0'),
        ('depth_chord', Real, None),
        ('depth_conservative', Real, None),
        ('iterations', ctypes.c_int, 'evaluations of that function'),
    ]


@_struct
class BodyCounts(Struct):
    """Numbers of bodies. inserted = present + removed + left holds at all times. `left` counts those that left through
    outflow boundaries and outlets.
    """
    c_name = 'dem_body_counts'
    rows = [
        ('inserted', ctypes.c_uint64, ''),
        ('present', ctypes.c_uint64, ''),
        ('removed', ctypes.c_uint64, ''),
        ('left', ctypes.c_uint64, ''),
    ]


@_struct
class MotionRow(Struct):
    """A pose or, for "servo", a load of a wall at a time."""
    c_name = 'dem_motion_row'
    positive = {'load': 'velocity is the direction in which the wall presses; reverse it to press the other way'}
    rows = [
        ('time', ctypes.c_double, 's, after start; the first is 0, ascending'),
        ('position', Vec3, 'm, displacement from the pose in which the motion started'),
        ('rotation', Quat, 'from that pose, about the displaced `point`; 0: not rotated'),
        ('load', Real, 'N, or Pa: see `load` of Motion; used instead of a pose'),
    ]


def _wrap_dem_motion_fn(function, context, struct):

    def call(time, pose, user):
        try:
            _pose = Pose.from_address(pose)
            result = function(time, _pose)
            if result is not None:
                raise _returned(result, 'motion')
            if _refs(_pose) > _ONE and _held(_pose):
                raise _kept('pose', 'motion')
        except BaseException as error:
            context.fail(error, 'motion')
            Real.from_address(pose).value = _NAN
    return ctypes.cast(ctypes.CFUNCTYPE(None, ctypes.c_double, ctypes.c_void_p, ctypes.c_void_p)(call), MotionFn.c)


MotionFn = Function(_wrap_dem_motion_fn, None, ctypes.c_double, ctypes.POINTER(Pose), ctypes.c_void_p)
MotionFn.__doc__ = 'A motion: sets the pose of a wall at a time (s). When it is called, *pose is where the wall was when it got the motion, at rest. It must be smooth, and velocity and spin must be the exact derivatives of position and rotation. It is called twice per step, for its end and its middle, from one thread. With impulses dem.h also calls it for the next step: it must be valid one step ahead. World.check calls it too, also for later times, and reports a velocity or spin that is not the derivative. A pose that is not finite, is clearly no rotation, or is beyond 1e15 (m, m/s, rad/s) stops the run with UnstableError.'


@_struct
class Motion(Struct):
    """The motion of a wall. It starts from the pose that the wall has when Wall.motion_set is called."""
    c_name = 'dem_motion'
    uses = {'velocity': (('kind', ('translating', 'oscillating', 'servo')),), 'speed': (('kind', ('rotating',)),),
            'amplitude': (('kind', ('oscillating',)),), 'frequency': (('kind', ('oscillating',)),), 'phase':
            (('kind', ('oscillating',)),), 'function': (('kind', ('user',)),), 'start': (('kind', ('translating',
            'rotating', 'oscillating', 'table', 'servo')),), 'ramp': (('kind', ('translating', 'rotating',
            'oscillating', 'servo')),), 'load': (('kind', ('servo',)), ('table', False)), 'area': (('kind',
            ('servo',)),), 'travel': (('kind', ('servo',)),), 'table': (('kind', ('table', 'servo')),),
            'table_repeats': (('kind', ('table',)),)}
    needs = {'translating': ('velocity',), 'rotating': ('speed',), 'oscillating': ('amplitude', 'frequency'),
            'servo': ('load table',)}
    positive = {'load': 'velocity is the direction in which the wall presses; reverse it to press the other way'}
    counts = {'table_count': (('table', 1),)}
    rows = [
        ('kind', MotionKind, ''),
        ('velocity', Vec3,
         'm/s, of translating walls; of oscillating ones the direction only; of servo walls the direction in '
         'which they press, and their largest speed'),
        ('point', Vec3,
         'm; point and direction of the axis of rotation, to which WallLoads also refers torques; axis 0 means'
         ' along z. Rotating walls need an axis.'),
        ('axis', Vec3, None),
        ('speed', Real, 'rad/s, of rotating walls'),
        ('amplitude', Real, 'm: of oscillating walls'),
        ('frequency', Real, 'Hz: of oscillating walls'),
        ('phase', Real, 'rad: of oscillating walls'),
        ('start', ctypes.c_double,
         's. Until then rotating, translating and servo walls are at rest. A time in the past means now.'),
        ('function', MotionFn,
         'The function of "user". It must not rotate a mesh or profile that spans a period, because the ends '
         'stay joined to those of its images: use a table.'),
        ('user', ctypes.c_void_p, 'passed to function'),
        ('ramp', ctypes.c_double,
         's, >= 0. The speed (translating, rotating), amplitude (oscillating) or load (servo) rises as 3 u^2 -'
         ' 2 u^3, u = (time - start)/ramp, to its full value. 0 means at once.'),
        ('load', Real,
         'N, of servo walls: the force with which the wall presses the grains along `velocity`. A table '
         'replaces it: linear between rows, constant after the last. Servo walls whose motions are equal are '
         'one piston and bear the load together. They need "springs".'),
        ('area', Real, 'm2, >= 0: load is a stress (Pa) on it; 0 means a force (N)'),
        ('travel', Real, 'm, >= 0, of servo walls: largest distance; 0 means no limit'),
        ('table', View(MotionRow, const=True),
         'The rows of "table", at least 2. Between rows the pose is a cubic, so that velocity and spin are '
         'continuous (tangents of the parabola through three rows). The wall is at rest before the first row '
         'and after the last. With table_repeats = 1 the table starts again after its last row, which should '
         'equal the first. From row to row the wall rotates by less than pi.'),
        ('table_count', ctypes.c_int, ''),
        ('table_repeats', ctypes.c_int, ''),
    ]


@_struct
class Mesh(Struct):
    """A triangle mesh: vertex_count x 3 coordinates (m), triangle_count x 3 vertex numbers from 0."""
    c_name = 'dem_mesh'
    counts = {'vertex_count': (('vertices', 3),), 'triangle_count': (('triangles', 3),)}
    rows = [
        ('vertex_count', ctypes.c_int, ''),
        ('triangle_count', ctypes.c_int, ''),
        ('vertices', View(Real, 'vertex_count', 3), ''),
        ('triangles', View(ctypes.c_int32, 'triangle_count', 3), ''),
    ]


@_struct
class Profile(Struct):
    """A profile: vertex_count x 2 coordinates (m), segment_count x 2 vertex numbers from 0."""
    c_name = 'dem_profile'
    counts = {'vertex_count': (('vertices', 2),), 'segment_count': (('segments', 2),)}
    rows = [
        ('vertex_count', ctypes.c_int, ''),
        ('segment_count', ctypes.c_int, ''),
        ('vertices', View(Real, 'vertex_count', 2), ''),
        ('segments', View(ctypes.c_int32, 'segment_count', 2), ''),
    ]


@_struct
class SieveDesc(Struct):
    """A sieve: a plane with rows of holes, infinite or cut out as a disc. The cost per sphere does not depend on the
    number of holes; that of a polyhedron on a plate grows with the holes below it.
    """
    c_name = 'dem_sieve_desc'
    required = ('kind', 'aperture', 'bar')
    rows = [
        ('kind', SieveKind, 'required'),
        ('point', Vec3, 'm, centre of a hole, at half the thickness'),
        ('normal', Vec3, 'across the sieve; 0 means along z'),
        ('along', Vec3,
         'Direction of the rows of holes; 0 means along x, or y if x is near the normal. The same holds for a '
         'direction within 0.001 rad of the normal.'),
        ('aperture', Real, 'm, required, > 0: clear width, side or diameter of a hole'),
        ('bar', Real, 'm, required, > 0: wire diameter, or width between two holes'),
        ('length', Real, 'm, of slots, >= aperture; 0 means infinite'),
        ('thickness', Real, 'm, of plates; 0 means a sheet with sharp rims'),
        ('lift', Real,
         'm, between the axes of the two layers of wires; 0 means one plane. `bar` puts one layer on the '
         'other; real wires wind between the two.'),
        ('staggered', ctypes.c_int, '1 puts round holes in a triangular pattern'),
        ('radius', Real, 'm, of the disc; 0 means an infinite sieve'),
        ('model', ctypes.c_int,
         'Rule of reduced holes. A sphere smaller than the hole falls if its centre is within (1 - clearance) '
         'b of the middle of the hole in both directions: b = aperture/2 - radius (model 0 or 1) or aperture/2'
         ' (model 2) [ALK07] eq 4.20, 4.21. Once it falls, it falls to the end.'),
        ('clearance', Real, 'reduced holes: 0 open, 1 closed; zeta of [ALK07]'),
    ]


@_struct
class WallLoads(Struct):
    """The loads of grains on a wall. Torques are about the point of its motion (of a wall without a motion: its own
    point, or the origin for profiles, meshes and walls of grains).
    """
    c_name = 'dem_wall_loads'
    rows = [
        ('force', Vec3, 'N, of the last step'),
        ('torque', Vec3, 'N m, of the last step'),
        ('torque_axial', Real, 'N m, component along the axis of its motion'),
        ('power', Real,
         'W, from the wall to the grains: -(force . v + torque . w), and the power of friction on a surface '
         'that moves in itself (Wall.surface_velocity_set)'),
        ('contacts', _Known(ctypes.c_int), 'present number'),
        ('touched', ctypes.c_int, '1 if a grain has touched the wall since it was added'),
        ('impulse', ctypes.c_double*3, 'N s. All that follow except `rate` are sums since Wall.loads_reset.'),
        ('torque_impulse', ctypes.c_double, 'N m s, of torque_axial'),
        ('work', ctypes.c_double, 'J, from the wall to the grains'),
        ('time', ctypes.c_double, 's, over which these sums extend'),
        ('rate', ctypes.c_double*BODY_REALS,
         'per s, last step: what laws gave to its numbers (World(body_reals=...)), in their units'),
        ('gained', ctypes.c_double*BODY_REALS, 'its sum over time'),
    ]


@_struct
class Joint(Id):
    """The motor of a revolute joint."""
    c_name = 'dem_joint'
    rows = [
        ('id', ctypes.c_int32, ''),
    ]

    def motor_set(self, motor, speed, torque):
        """Replaces the motor of a joint from the next step on. The values are those of JointDesc."""
        self.world._ok(_lib.dem_joint_motor_set(self.world._c, self, _enum_of(motor, Motor, 'Joint.motor_set: motor'),
            speed, torque))

    @property
    def state(self):
        """Returns the state of a joint.

        Returns: JointState
        """
        state = JointState()
        self.world._ok(_lib.dem_joint_get(self.world._c, self, state))
        self.world._with(state)
        return state

    def remove(self):
        """Removes a joint."""
        self.world._ok(_lib.dem_joint_remove(self.world._c, self))


@_struct
class JointDesc(Struct):
    """A joint. Its point and axis refer to the present poses of the bodies."""
    c_name = 'dem_joint_desc'
    uses = {'axis': (('kind', ('revolute',)),), 'motor': (('kind', ('revolute',)),), 'speed': (('motor',
            ('speed',)),), 'torque': (('motor', ('speed', 'torque')),), 'wall': (('b', False),)}
    required = ('kind', 'a')
    rows = [
        ('kind', JointKind, 'required: how the two are joined'),
        ('motor', Motor, ''),
        ('a', Body, 'required'),
        ('b', Body, 'None means `wall`, or space'),
        ('wall', Wall, 'if b is None: moves with it; None means space, at rest'),
        ('collide', ctypes.c_int, '1: the two bodies may touch each other'),
        ('point', Vec3, 'm, where the two are joined'),
        ('axis', Vec3, 'of a revolute joint, not 0; planar worlds: along z'),
        ('speed', Real, 'rad/s, of a against b about axis, right-handed; at most 1e12 in size'),
        ('torque', Real,
         'N m, on a about axis; at most 1e12 in size. "speed": the largest torque, >= 0; 0 means no limit.'),
    ]


@_struct
class JointState(Struct):
    """The state of a joint."""
    c_name = 'dem_joint_state'
    rows = [
        ('force', Vec3, 'N, N m about the joined point: on a (b has the opposite), of the last step, with the motor'),
        ('torque', Vec3, None),
        ('motor_torque', Real, 'N m, on a about axis, of the last step'),
        ('power', Real, 'W, from the motor to a and b; 0 without a motor'),
        ('gap', Real, 'in the middle of the coming step: m between the points'),
        ('tilt', Real, 'in the middle of the coming step: sine of the angle of the axes'),
        ('turned', ctypes.c_double, 'rad, of a against b about axis since the joint was added'),
        ('work', ctypes.c_double, 'J, of the motor'),
    ]


@_struct
class RailDesc(Struct):
    """A rail. Components of velocity and spin along axes that are not locked are ignored."""
    c_name = 'dem_rail_desc'
    uses = {'velocity': (('axes', True),), 'spin': (('axes', True),), 'wall': (('axes', True),)}
    rows = [
        ('axes', ctypes.c_int, '0 to 63: sum of dem.RAIL_ constants; 0 means no rail'),
        ('velocity', Vec3, 'm/s, along locked axes'),
        ('spin', Vec3, 'rad/s, about locked axes'),
        ('wall', Wall,
         'Along and about locked axes the body also follows the pose of this wall, as if it were part of it, '
         'so any motion of a wall is a path for a body. None means none, as after the removal of the wall.'),
    ]


@_struct
class RailState(Struct):
    """The reaction of a rail: what it exerts on the body."""
    c_name = 'dem_rail_state'
    rows = [
        ('desc', RailDesc, 'as set'),
        ('force', Vec3, 'N, at the present time'),
        ('torque', Vec3, "N m, about the body's centre"),
        ('power', ctypes.c_double, 'W, of the rail on the body'),
        ('work', ctypes.c_double, 'J, since the rail was set'),
    ]


@_struct
class Feed(Id):
    """bins of the distribution of residence times"""
    c_name = 'dem_feed'
    rows = [
        ('id', ctypes.c_int32, ''),
    ]

    @property
    def state(self):
        """Returns the state of a feed.

        Returns: FeedState
        """
        state = FeedState()
        self.world._ok(_lib.dem_feed_get(self.world._c, self, state))
        self.world._with(state)
        return state


@_struct
class Outlet(Id):
    """id counts from 1"""
    c_name = 'dem_outlet'
    rows = [
        ('id', ctypes.c_int32, ''),
    ]

    @property
    def state(self):
        """Returns the counts of an outlet.

        Returns: OutletState
        """
        state = OutletState()
        self.world._ok(_lib.dem_outlet_get(self.world._c, self, state))
        self.world._with(state)
        return state

    def reset(self):
        """Sets the counts of an outlet to 0. BodyCounts stays; grains inside have not entered."""
        self.world._ok(_lib.dem_outlet_reset(self.world._c, self))

    def residence_csv_write(self, path):
        """Writes the distribution of the residence times of an outlet with residence_bin: for each bin up to the last
        one in use its middle (s), its grains, their fraction per s, and the fraction of all grains up to its end.
        """
        self.world._ok(_lib.dem_outlet_residence_csv_write(self.world._c, self, _text_of(path,
            'Outlet.residence_csv_write: path')))


@_struct
class FeedDesc(Struct):
    """A feed adds grains while the world runs, at random free positions in a region (free as in World.spheres_fill), at
    a rate or all at once. A grain for which there is no room waits; none is lost. Most grains join the present
    neighbour list. The list is rebuilt for the first grain of a new radius or material, and for every grain if the
    world has bodies that are not spheres.
    """
    c_name = 'dem_feed_desc'
    required = ('material', 'radius', 'box')
    counts = {'class_count': (('radius', 1), ('amount', 1), ('materials', 1), ('shapes', 1), ('sizes', 1))}
    rows = [
        ('material', Material, 'required'),
        ('class_count', ctypes.c_int, 'required, 1 to 16: size classes'),
        ('radius', Real*CLASSES, 'm, required'),
        ('amount', ctypes.c_double*CLASSES,
         '> 0: relative amounts of the classes, or with `limited` grains (kg with by_mass)'),
        ('limited', ctypes.c_int, '1: the feed ends after `amount`, drawn without replacement'),
        ('by_mass', ctypes.c_int, '1: amount and rate are in kg and kg/s instead of grains'),
        ('rate', ctypes.c_double, '1/s, grains due; 0 means all as room permits, and needs limited'),
        ('start', ctypes.c_double,
         's, time of the world. A feed that is added later catches up with what was due since start.'),
        ('end', ctypes.c_double, 's, 0 or >= start; 0 means no end'),
        ('box', Box, 'm, required: centres lie inside (Region: whole bodies)'),
        ('round', ctypes.c_int, '1: only the vertical elliptic cylinder inscribed in the box'),
        ('velocity', Vec3, 'm/s, of new grains'),
        ('spread', Real, 'm/s, largest random change of each component of velocity'),
        ('seed', ctypes.c_uint64, 'of random positions, sizes and velocities'),
        ('inside', InsideFn, 'restricts the box further, as in Region'),
        ('inside_user', ctypes.c_void_p, 'passed to inside'),
        ('materials', Material*CLASSES,
         'A mixture: for each class, if not 0, its material; its shape, in random orientations and with the '
         'volume of a sphere of `radius`; and the distribution of its radius (copied).'),
        ('shapes', Shape*CLASSES, ''),
        ('sizes', ctypes.POINTER(Sizes)*CLASSES, ''),
    ]


@_struct
class FeedState(Struct):
    """The state of a feed."""
    c_name = 'dem_feed_state'
    rows = [
        ('fed', ctypes.c_uint64*CLASSES, 'grains added, per class and in all'),
        ('total', ctypes.c_uint64, None),
        ('mass', ctypes.c_double, 'kg, added'),
        ('waiting', ctypes.c_uint64, 'grains due but without room; by mass at a rate: 0 or 1'),
        ('done', ctypes.c_int, '1: no more grains will be added'),
    ]


@_struct
class OutletDesc(Struct):
    """An outlet removes the grains, fixed ones included, whose centre is in a region, and counts them; BodyCounts counts
    them as left. It checks whenever the neighbour list is rebuilt and every 64 steps: a grain is up to half a skin or
    64 steps inside before it is removed, so that many grains that leave one by one cost little. A region thinner than
    half a skin may miss grains. Bodies that are not spheres count with the radius of their bounding sphere. With
    `keep` an outlet only counts the grains that enter, go back and are inside. The discharge through a plane is what
    enters the box behind it.
    """
    c_name = 'dem_outlet_desc'
    required = ('box',)
    counts = {'class_count': (('radius', 1),)}
    rows = [
        ('frame', Wall, 'the region moves with this wall; None means at rest'),
        ('box', Box, 'm, required, in that frame; lo < hi on every axis (planar worlds: z may be 0 to 0)'),
        ('beyond', Real, "m: only grains this far or farther from the frame's z axis"),
        ('wanted_min', Real, 'm, radii meant to leave here; max 0 means no limit'),
        ('wanted_max', Real, None),
        ('class_count', ctypes.c_int, 'size classes to count in, 0 to 16'),
        ('radius', Real*CLASSES, 'm, ascending; a grain counts in the nearest class'),
        ('material', Material, 'only grains of this material; None means all'),
        ('keep', ctypes.c_int, '1: grains stay and are only counted; at most 16 such'),
        ('residence_bin', ctypes.c_double,
         's, >= 0: width of a bin of residence times, which run from the insertion of a grain (grains that '
         'were there before: from World.outlet) until the outlet counts it; 0: not measured'),
    ]


@_struct
class OutletState(Struct):
    """The counts of an outlet: grains that were removed or, with `keep`, that entered."""
    c_name = 'dem_outlet_state'
    rows = [
        ('count', ctypes.c_uint64*CLASSES, 'grains, per class and in all'),
        ('total', ctypes.c_uint64, None),
        ('mass', ctypes.c_double*CLASSES, 'kg'),
        ('total_mass', ctypes.c_double, None),
        ('sorted', ctypes.c_uint64, 'grains of wanted radii, and others: [ALK07] s_i and g_i'),
        ('gangue', ctypes.c_uint64, None),
        ('sorted_mass', ctypes.c_double, 'kg'),
        ('gangue_mass', ctypes.c_double, None),
        ('since', ctypes.c_double, 's: when counting began'),
        ('last', ctypes.c_double, 's: when the last grain was counted'),
        ('back', ctypes.c_uint64*CLASSES,
         '`keep` only: grains that went back, and grains that are inside now. Grains that were inside when '
         'counting began have not entered.'),
        ('held', ctypes.c_uint64*CLASSES, None),
        ('back_total', ctypes.c_uint64, None),
        ('held_total', ctypes.c_uint64, None),
        ('back_mass', ctypes.c_double*CLASSES, 'kg'),
        ('held_mass', ctypes.c_double*CLASSES, None),
        ('back_total_mass', ctypes.c_double, None),
        ('held_total_mass', ctypes.c_double, None),
        ('residence', ctypes.c_double*CLASSES,
         'residence_bin only: sums over the counted grains, per class, of their residence times, s, and of the'
         ' squares, s2: the mean of class k is residence[k]/count[k]. Grains per bin; the last bin has all '
         'longer times.'),
        ('residence_square', ctypes.c_double*CLASSES, None),
        ('residence_count', ctypes.c_uint64*RESIDENCE_BINS, ''),
    ]


@_struct
class Advice(Struct):
    """The time step that a scene allows, and what limits it."""
    c_name = 'dem_advice'
    rows = [
        ('dt', Real, 's, the proposed step: contact_time/50, or a fifth of the largest stable step if less'),
        ('dt_max', Real,
         's, the largest step that a run accepts: contact_time/20 [ALK07] eq 2.22, or the largest stable step '
         'if less. Stability is that of contacts to come, with their dashpots, friction and rolling '
         'resistance.'),
        ('contact_time', Real, 's, duration of the shortest contact'),
        ('rayleigh', Real,
         's, the smallest Rayleigh time pi R sqrt(rho/G)/(0.1631 nu + 0.8766) of the smallest grains of each '
         'material; for comparison only'),
        ('speed', Real,
         'm/s, the impact speed assumed: World(impact_speed=...); if that is 0, the largest of the speeds of '
         'grains, feeds and walls and of a fall through the height of the scene, at least 1e-3'),
        ('binds', Text(160), 'the contact that limits the step: materials, radii, speed'),
    ]


@_struct
class Finding(Struct):
    """One likely mistake in a scene."""
    c_name = 'dem_finding'
    rows = [
        ('severity', Severity, ''),
        ('text', Text(240), 'what is wrong, its value, the likely cause, the remedy'),
    ]


@_struct
class CellDesc(Struct):
    """How the sides of a periodic domain, the cell, move."""
    c_name = 'dem_cell_desc'
    uses = {'stress': (('rate_most', True),)}
    rows = [
        ('rate', Vec3, '1/s, strain rate of each axis; positive: the cell becomes longer'),
        ('shear', Real, '1/s, shear rate: change of the velocity along x with y'),
        ('stress', Vec3, 'Pa, pressure positive: target of axes that have a rate_most'),
        ('rate_most', Vec3,
         '1/s, >= 0: largest strain rate by which the cell is led to `stress` along this axis, whose `rate` '
         'must be 0; 0: the axis follows `rate`'),
    ]


@_struct
class CellState(Struct):
    """What the cell does."""
    c_name = 'dem_cell_state'
    rows = [
        ('box', Box, 'm, the domain now'),
        ('offset', Real, 'm, along x: displacement of images across the upper y face'),
        ('strain', ctypes.c_double*3, 'since the beginning: logarithmic strain of each axis, > 0: longer'),
        ('shear', ctypes.c_double, 'since the beginning: shear strain'),
        ('rate', ctypes.c_double*3, '1/s, of the last step'),
        ('shear_rate', ctypes.c_double, None),
        ('stress', ctypes.c_double*3, 'Pa, along each axis, before the last step; at first 0'),
    ]


@_struct
class Counters(Struct):
    """Counters of a world. Checkpoints store them."""
    c_name = 'dem_counters'
    rows = [
        ('steps', ctypes.c_uint64, 'steps taken'),
        ('rebuilds', ctypes.c_uint64, 'rebuilds of the neighbour list'),
        ('candidates', ctypes.c_int, 'of the last step: candidate pairs of bodies'),
        ('contacts', ctypes.c_int, 'of the last step: contacts between bodies'),
        ('wall_contacts', ctypes.c_int,
         'of the last step: contacts with walls. A contact of polyhedra counts once. With impulses a contact '
         'counts if its impulse is not 0.'),
        ('overlap_max', Real,
         'largest overlap since the last reset, over the smaller radius (of other shapes: over the smaller '
         'half width along the normal). A run stops at 1.'),
        ('speed_max', Real, 'm/s, of the fastest body, at the last step'),
        ('skin', Real, 'm, in use'),
        ('dt', Real, 's, in use'),
        ('search', Search, 'in use'),
        ('threads', ctypes.c_int, 'OpenMP threads'),
        ('domains', ctypes.c_int, 'work groups (see the glossary)'),
        ('sweeps', ctypes.c_int, 'impulses: sweeps of the last step'),
        ('residual', Real,
         'impulses: m/s, largest and root mean square change of a contact velocity in the last sweep of the '
         'last step; compare World(tolerance=...)'),
        ('residual_rms', Real, None),
        ('unsolved', ctypes.c_uint64,
         'impulses: solves whose sweeps did not reach the tolerance. dem.h solves once per step, and once more'
         ' after the scene has changed, for instance when a feed has added a grain'),
        ('memory', ctypes.c_size_t, 'bytes allocated by the world'),
    ]


@_struct
class Ledger(Struct):
    """The account of energy, J, since the world was created; zeros unless World(ledger=1). residual = kinetic +
    rotational + elastic - gravity - walls - force - cell - inserted - growth + removed + normal + slide + tangent +
    rolling The residual is the error of the time integration; compare it with `throughput`. Potential energy is not
    stored energy here: `gravity` is the work of gravity. If a user-defined law never fills force.energy, the ledger
    cannot separate what the law stores from what it dissipates: `unknown` then holds the residual, and `residual` is
    0.
    """
    c_name = 'dem_ledger'
    rows = [
        ('kinetic', ctypes.c_double, 'stored now'),
        ('rotational', ctypes.c_double, None),
        ('elastic', ctypes.c_double, None),
        ('gravity', ctypes.c_double, 'supplied: work of gravity'),
        ('walls', ctypes.c_double, 'supplied: work of moving walls, belts, motors and rails'),
        ('force', ctypes.c_double, 'supplied: work of force fields'),
        ('cell', ctypes.c_double, 'supplied: work of a cell that deforms'),
        ('inserted', ctypes.c_double,
         'supplied: kinetic energy of inserted bodies, and its changes by Body.set and other calls that set '
         'velocities, fix bodies or change masses'),
        ('normal', ctypes.c_double, 'dissipated: by normal dashpots, hysteresis, impacts and joints'),
        ('slide', ctypes.c_double, 'dissipated: by sliding'),
        ('tangent', ctypes.c_double, 'dissipated: by tangential dashpots'),
        ('rolling', ctypes.c_double, 'dissipated: by rolling resistance'),
        ('removed', ctypes.c_double, 'kinetic energy of removed bodies'),
        ('throughput', ctypes.c_double, 'sum of the magnitudes of what was supplied'),
        ('growth', ctypes.c_double,
         'supplied: what springs gain when the scene changes and nothing moves: radii grow, bodies or walls '
         'are added, moved or removed between steps, materials change. In the residual are: what springs hold '
         'on a grain that an outlet or outflow boundary removes, what they gain when two walls in one place '
         "part below a grain, what a contact holds as it leaves its law's range."),
        ('residual', ctypes.c_double, ''),
        ('unknown', ctypes.c_double, '> 0: the user-defined law created energy'),
    ]


@_struct
class Totals(Struct):
    """Totals over all bodies that can move."""
    c_name = 'dem_totals'
    rows = [
        ('mass', ctypes.c_double, 'kg'),
        ('kinetic', ctypes.c_double, 'J'),
        ('rotational', ctypes.c_double, None),
        ('centre', ctypes.c_double*3, 'centre of mass, m'),
        ('momentum', ctypes.c_double*3, 'momentum, kg m/s'),
        ('angular', ctypes.c_double*3, 'angular momentum about the origin, kg m2/s'),
    ]


def _wrap_dem_observer_fn(function, context, struct):

    def call(world, user):
        try:
            result = _real_from(function(context.world(world)), 'observer')
            return result
        except BaseException as error:
            context.fail(error)
            return _NAN
    return ctypes.cast(ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_void_p, ctypes.c_void_p)(call), ObserverFn.c)


ObserverFn = Function(_wrap_dem_observer_fn, ctypes.c_double, ctypes.c_void_p, ctypes.c_void_p)
ObserverFn.__doc__ = 'Returns one number by which a world is judged, an observable. Averages over many grains or a long time are good observables. Positions are not: once grains collide, they depend on round-off.'


@_struct
class Observable(Struct):
    """A named observable."""
    c_name = 'dem_observable'
    rows = [
        ('name', str, '`unit` or None; both must outlive the Trials'),
        ('unit', str, None),
        ('function', ObserverFn, ''),
        ('user', ctypes.c_void_p, 'passed to `function`; or None'),
        ('scale', ctypes.c_double, '>= 0, divides deviations; 0: the value of the reference'),
    ]


def _wrap_dem_progress_fn(function, context, struct):

    def call(world, done, seconds_left, user):
        try:
            result = int(bool(function(context.world(world), done, seconds_left)) or context.raised is not None or context.stop)
            return result
        except BaseException as error:
            context.fail(error)
            return 1
    return ctypes.cast(ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_double, ctypes.c_double, ctypes.c_void_p)(call), ProgressFn.c)


ProgressFn = Function(_wrap_dem_progress_fn, ctypes.c_int, ctypes.c_void_p, ctypes.c_double, ctypes.c_double, ctypes.c_void_p)
ProgressFn.__doc__ = 'Receives the progress of a run, about ten times per second of wall time and once at the end. done: fraction, 0 to 1. seconds_left: estimated wall time, s. A non-zero return value stops the run with StoppedError and leaves the state intact; at the end it has no effect.'


@_struct
class TrialsDesc(Struct):
    """How World.trials_run works."""
    c_name = 'dem_trials_desc'
    required = ('duration',)
    counts = {'observable_count': (('observables', 1),)}
    rows = [
        ('duration', ctypes.c_double,
         's, required, > 0: simulated by each run, at least 64 steps. Observables are averaged over its second'
         ' half.'),
        ('budget', ctypes.c_double,
         's, wall time of all trials, estimated from some steps of the scene; 0 means 60 s. If it is too '
         'short, the runs simulate less.'),
        ('tolerance', ctypes.c_double, 'allowed deviation of an observable/its scale; 0 means 0.02'),
        ('seeds', ctypes.c_int,
         '0 to 16, not 1: runs per trial, which start from positions that differ by at most 1e-6 of a radius; '
         '0 means 3'),
        ('observable_count', ctypes.c_int,
         'observables to compare; 0 means three. These are height, scaled by its value above the lowest grain;'
         ' kinetic, scaled by the present energy plus that of a fall of all grains by their radius; contacts.'),
        ('observables', Observable*OBSERVABLES, ''),
        ('progress', ProgressFn,
         'called with the original world after each trial; None means no call. A non-zero return value ends '
         'World.trials_run with StoppedError.'),
        ('user', ctypes.c_void_p, 'passed to `progress`; or None'),
    ]


@_struct
class Trial(Struct):
    """The result of one trial."""
    c_name = 'dem_trial'
    rows = [
        ('name', str, 'how the trial differs from the scene'),
        ('step', ctypes.c_double,
         'factor on dt/contact_time, dt given or chosen. stiffness: factor on all moduli and stiffnesses; '
         'normal_damping of a pair is multiplied by its root.'),
        ('stiffness', ctypes.c_double,
         'step: factor on dt/contact_time, dt given or chosen. stiffness: factor on all moduli and '
         'stiffnesses; normal_damping of a pair is multiplied by its root.'),
        ('dt', ctypes.c_double, 's, at the end'),
        ('done', ctypes.c_int, 'runs that reached their end, 0 to seeds'),
        ('seconds', ctypes.c_double, 'wall time per simulated second'),
        ('value', ctypes.c_double*OBSERVABLES, 'mean over runs'),
        ('error', ctypes.c_double*OBSERVABLES, 'standard error'),
        ('drift', ctypes.c_double*OBSERVABLES, 'deviation from the reference, over the scale'),
        ('promise', ctypes.c_double,
         'every observable is within this of the reference, over its scale: the largest |drift| plus the '
         'statistical error (95 % for each observable). Infinite if a run did not reach its end.'),
        ('refusal', Text(200), 'why a run did not reach its end'),
    ]


@_struct
class Trials(Struct):
    """The results of World.trials_run."""
    c_name = 'dem_trials'
    rows = [
        ('count', ctypes.c_int, 'trials'),
        ('best', ctypes.c_int, 'index of the best one, 0: the scene as it is'),
        ('reference', ctypes.c_int, 'index of the trial with the smallest step'),
        ('duration', ctypes.c_double, 's simulated by each run'),
        ('tolerance', ctypes.c_double, 'tolerance applied'),
        ('seeds', ctypes.c_int, 'runs per trial'),
        ('observable_count', ctypes.c_int, 'observables'),
        ('observables', Observable*OBSERVABLES, ''),
        ('trial', Trial*TRIALS, ''),
        ('advice', Text(400), 'what to do, and why'),
    ]


@_struct
class ContactInfo(Struct):
    """One contact."""
    c_name = 'dem_contact_info'
    rows = [
        ('a', Body, 'b is None for a contact with a wall'),
        ('b', Body, None),
        ('wall', ctypes.c_int32, 'Wall id; 0: b is a body'),
        ('point', Vec3, 'm, on the surface of a wall'),
        ('normal', Vec3, 'unit, from a to b'),
        ('overlap', Real, 'm; < 0: a gap within the range of the law'),
        ('force', Vec3, 'N, on a'),
        ('further', ctypes.c_int, "1: another point of the polyhedron's contact before"),
    ]


@_struct
class Event(Struct):
    """A contact of two bodies, or of a body and a wall, from its beginning to its end. It exists while any of their
    contact points has an overlap, or while a law with a range exerts a force beyond contact; with impulses, while its
    impulse is not 0. Bodies of several spheres and walls of several facets have one contact with each other.
    """
    c_name = 'dem_event'
    rows = [
        ('kind', EventKind, ''),
        ('a', Body, 'a has the lower slot'),
        ('b', Body, 'None for a contact with a wall'),
        ('wall', ctypes.c_int32, 'Wall id; 0: b is a body'),
        ('material_a', Material, ''),
        ('material_b', Material, ''),
        ('cut', ctypes.c_int,
         '1: recording began during the contact; 2: it ended because a body or the wall was removed; 3: both. '
         'Else 0.'),
        ('point', Vec3, 'm: where it began'),
        ('normal', Vec3, 'unit, from a to b: where it began'),
        ('begin', ctypes.c_double, 's'),
        ('end', ctypes.c_double, 'the present time unless kind is "end"'),
        ('closing_speed', ctypes.c_double,
         'm/s, relative velocity at the contact point when it began: along the normal, > 0 if the two approach'),
        ('slip_speed', ctypes.c_double,
         'm/s, relative velocity at the contact point when it began: across it. They belong to the first step '
         'of the contact.'),
        ('mass', ctypes.c_double,
         'kg, effective mass m_a m_b/(m_a + m_b) for a central impact; fixed bodies and walls are infinitely '
         'heavy; 0: neither can move'),
        ('force', ctypes.c_double,
         'N, the largest normal force, summed over contact points (of impulses the mean over a step)'),
        ('impulse', ctypes.c_double, 'N s, the normal force summed over time'),
        ('lost_normal', ctypes.c_double,
         'J, energy lost so far as in Ledger: by the normal law, by sliding, by tangential dashpots (and '
         'springs that held energy at the end; what they stored when recording began counts as supplied), by '
         'rolling resistance'),
        ('lost_slide', ctypes.c_double, None),
        ('lost_tangent', ctypes.c_double, None),
        ('lost_rolling', ctypes.c_double, None),
    ]


def _wrap_dem_event_fn(function, context, struct):
    event_of = _read(Event).from_address

    def call(event, user):
        try:
            _event = event_of(event)
            function(_event)
            if _refs(_event) > _ONE and _held(_event):
                raise _kept('event', 'event')
        except BaseException as error:
            context.fail(error)
    return ctypes.cast(ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)(call), EventFn.c)


EventFn = Function(_wrap_dem_event_fn, None, ctypes.POINTER(Event), ctypes.c_void_p)
EventFn.__doc__ = 'Receives one contact. It may only read the world.'


@_struct
class EventsDesc(Struct):
    """How contacts are recorded."""
    c_name = 'dem_events_desc'
    uses = {'begins': (('function', True),)}
    rows = [
        ('function', EventFn,
         'called after each step for the contacts that have ended in it; None means no call. The contacts are '
         'in the order of their ids, for any number of threads and slabs.'),
        ('user', ctypes.c_void_p, 'passed to `function`; or None'),
        ('begins', ctypes.c_int, '1: also called for contacts that have begun, before those'),
    ]


@_struct
class Impacts(Struct):
    """Statistics of the recorded contacts."""
    c_name = 'dem_impacts'
    rows = [
        ('seconds', ctypes.c_double, 's, recorded so far'),
        ('ended', ctypes.c_double, 'number of contacts that have ended'),
        ('open', ctypes.c_int, 'number of contacts that exist'),
        ('rate', ctypes.c_double, '1/s: ended/seconds'),
        ('lost_normal', ctypes.c_double,
         'J, lost in all recorded contacts, those that exist included. For all materials these are what the '
         'ledger has booked since recording began, except losses of joints.'),
        ('lost_slide', ctypes.c_double, None),
        ('lost_tangent', ctypes.c_double, None),
        ('lost_rolling', ctypes.c_double, None),
        ('bin', ctypes.c_double*IMPACT_LIMITS, 'J, limits of the bins'),
        ('impacts', ctypes.c_double*IMPACT_BINS,
         'contacts that have ended, by energy of impact mass*closing_speed^2/2; those that had begun before '
         'the recording are not counted'),
        ('losses', ctypes.c_double*IMPACT_BINS,
         'contacts that have ended, by energy lost in them (the sum of all four losses)'),
        ('energy', ctypes.c_double*IMPACT_BINS, 'the energy lost in the contacts of each bin, J'),
    ]


@_struct
class Wear(Struct):
    """Wear of a wall since recording began."""
    c_name = 'dem_wear'
    rows = [
        ('seconds', ctypes.c_double, 's, recorded so far'),
        ('slide', ctypes.c_double, 'J, lost on it by sliding'),
        ('normal', ctypes.c_double, 'J, lost on it by the normal law'),
        ('volume', ctypes.c_double, 'm3, coefficient*slide/hardness'),
    ]


@_struct
class Servo(Struct):
    """What a servo wall ("servo") does. Force, speed and distance are along the direction of its velocity, in which it
    presses the grains; a piston of several walls has one state.
    """
    c_name = 'dem_servo'
    rows = [
        ('target', ctypes.c_double, 'N: force to reach and force on the grains, now'),
        ('force', ctypes.c_double, None),
        ('speed', ctypes.c_double, 'm/s'),
        ('travel', ctypes.c_double, 'm, from the pose in which the motion began'),
        ('stiffness', ctypes.c_double,
         'N/m, N s/m: sums over the contacts of the wall when its speed was chosen, at `time` (s). They set '
         'the gain. The speed changes from u to v with stiffness dt (v - 0.9 u) + damping (v - u) = (target - '
         'force)/2, and is at most the largest one.'),
        ('damping', ctypes.c_double, None),
        ('time', ctypes.c_double, None),
    ]


@_struct
class Stress(Struct):
    """Stress and fabric of the whole domain. Tensors are xx yy zz xy xz yz."""
    c_name = 'dem_stress'
    rows = [
        ('volume', ctypes.c_double, 'm3, of the domain'),
        ('solid', ctypes.c_double, 'fraction that bodies fill'),
        ('contact', ctypes.c_double*6,
         'Pa, pressure positive: of contacts, the sum of force x branch over the volume'),
        ('kinetic', ctypes.c_double*6,
         'Pa, pressure positive: of motion, the sum of m v v over the volume, about the mean velocity'),
        ('total', ctypes.c_double*6,
         'Pa, pressure positive: both together. The branch of a contact with a wall ends on the surface of the'
         ' wall. At rest without weight, stress x volume is therefore the sum of force x position over the '
         'contact points on all walls: between two planes their force x distance, at curved walls that sum '
         'over the curved surface.'),
        ('fabric', ctypes.c_double*6, 'mean of n n over the contacts of two bodies; its trace is 1'),
        ('contacts', ctypes.c_int, 'of two bodies'),
        ('coordination', ctypes.c_double, 'contacts per body, with walls'),
    ]


@_struct
class FieldDesc(Struct):
    """A field: a grid of cells on which a run averages solid fraction, velocity and, if desired, stress over a window of
    time. A grain counts in the cell of its centre ([MIL] 5.2.9), so cells smaller than grains need a long window; or
    it is spread about its centre by coarse graining (width).
    """
    c_name = 'dem_field_desc'
    required = ('box', 'cells')
    rows = [
        ('box', Box,
         'm, required: what the cells divide. In planar worlds cells are World(thickness=...) deep, whatever '
         'the extent of the box along z, which must contain 0.'),
        ('cells', ctypes.c_int*3, 'required, >= 1: along each axis, at most 2^28 in all'),
        ('start', ctypes.c_double, 's, window of time; end 0 means no end'),
        ('end', ctypes.c_double, None),
        ('interval', ctypes.c_double, 's, from start on; 0 means every 100 steps of the present dt'),
        ('material', Material, 'only grains of this material; None means all grains'),
        ('radius_min', Real, 'm, only of these (bounding) radii; max 0 means any'),
        ('radius_max', Real, None),
        ('stress', ctypes.c_int, '1: also flux, stress and contacts; visits every contact'),
        ('width', Real,
         "m, of coarse graining; 0 means none. Each grain is then spread by Lucy's function of reach c = 2 "
         'width [GOL10], 105/(16 pi c^3) (1 + 3 r/c) (1 - r/c)^3 (planar: 5/(pi c^2) in place of the first '
         'factor), evaluated at the centres of cells. Keep cells no longer than width.'),
        ('group', Group, 'only members of this group; None means all grains'),
        ('variance', ctypes.c_int, '1: also variances of cells over the samples; not in slabs'),
        ('bodies', ctypes.c_int, '1: also averages each grain (BodyMeans); one field may'),
    ]


@_struct
class FieldData(Struct):
    """The sums of a field over its samples. Cell (i, j, k) has index i + cells[0]*(j + cells[1]*k). The pointers are
    valid until the next step.
    """
    c_name = 'dem_field_data'
    rows = [
        ('cells', ctypes.c_int*3, ''),
        ('box', Box, 'm'),
        ('samples', ctypes.c_uint64, 'number of samples'),
        ('solid', View(ctypes.c_double, 'cells', const=True),
         'cells: sum of the volume of grains over that of the cell'),
        ('mass', View(ctypes.c_double, 'cells', const=True), 'cells: sum of masses, kg'),
        ('momentum', View(ctypes.c_double, 'cells', 3, const=True),
         'cells x 3: sum of momenta, kg m/s; velocity = momentum/mass'),
        ('grains', View(ctypes.c_double, 'cells', const=True), 'cells: sum of the number of grains'),
        ('flux', View(ctypes.c_double, 'cells', 6, const=True),
         'None unless stress is 1. flux: cells x 6 (xx yy zz xy xz yz), Pa: sum over grains of m v v over the '
         'volume of the cell stress: cells x 6, Pa, pressure positive: sum over contacts of force x branch '
         'over the volume of the cell. A contact of two grains acts along the line between their centres, and '
         "each grain accounts for its half; one with a wall acts from the centre to the wall's surface. "
         'contacts: cells: sum of the number of contacts of the grains'),
        ('stress', View(ctypes.c_double, 'cells', 6, const=True), None),
        ('contacts', View(ctypes.c_double, 'cells', const=True), None),
    ]


@_struct
class FieldCell(Struct):
    """Means of one cell over the samples; 0 where no grain was."""
    c_name = 'dem_field_cell'
    rows = [
        ('grains', ctypes.c_double, 'number of grains in the cell'),
        ('solid', ctypes.c_double, 'solid fraction'),
        ('density', ctypes.c_double, 'bulk density, kg/m3'),
        ('velocity', ctypes.c_double*3, 'm/s, weighted by mass'),
        ('temperature', ctypes.c_double, 'm2/s2, per axis, about that velocity; 0 unless stress is 1'),
        ('stress', ctypes.c_double*6,
         'Pa, xx yy zz xy xz yz, pressure positive: of contacts and of motion about that velocity; 0 unless '
         'stress is 1'),
        ('coordination', ctypes.c_double, 'contacts per grain, with walls; 0 unless stress is 1'),
        ('grains_variance', ctypes.c_double,
         'Variances over the samples, of the values of the whole cell; 0 unless variance is 1: of grains, '
         'solid, density, (kg/m3)^2, and velocity, m2/s2, weighted by mass. The mean of n independent samples '
         'has the standard error sqrt(variance/n).'),
        ('solid_variance', ctypes.c_double, None),
        ('density_variance', ctypes.c_double, None),
        ('velocity_variance', ctypes.c_double*3, None),
    ]


@_struct
class BodyMeans(Struct):
    """Averages of one grain over the samples of the field with bodies, wherever the grain was. The field chooses grains
    by material, radius and group.
    """
    c_name = 'dem_body_means'
    rows = [
        ('samples', ctypes.c_uint64, 'number of samples; 0: all others are 0'),
        ('velocity', ctypes.c_double*3, 'm/s'),
        ('velocity_variance', ctypes.c_double*3, 'm2/s2'),
        ('spin', ctypes.c_double*3, 'rad/s'),
        ('spin_variance', ctypes.c_double*3, '(rad/s)^2'),
        ('force', ctypes.c_double*3, 'N: of contacts and fields, not of gravity'),
        ('force_variance', ctypes.c_double*3, 'N2: of contacts and fields, not of gravity'),
    ]


@_struct
class MixingDesc(Struct):
    """Two components of a mixture: the grains of one material or of a range of radii, and all others. Only grains in
    `box` that can move count.
    """
    c_name = 'dem_mixing_desc'
    uses = {'centre': (('axis', True),)}
    required = ('box', 'cells')
    rows = [
        ('box', Box, 'm, required: what the cells divide'),
        ('cells', ctypes.c_int*3, 'required, >= 1: along each axis; 10 to 30 grains per cell suit'),
        ('material', Material,
         'the component: a material (id 0: any), and (bounding) radii, m (max 0: any); not both open'),
        ('radius_min', Real, ''),
        ('radius_max', Real, ''),
        ('centre', Vec3, 'm, a point on an axis'),
        ('axis', Vec3, 'its direction, of any length, 0: no axis'),
    ]


@_struct
class Mixing(Struct):
    """Mixing of two components. Indices that are not defined are NaN: if one component is absent, if all grains are in
    one cell, or if no cell has two grains.
    """
    c_name = 'dem_mixing'
    rows = [
        ('grains', ctypes.c_int, 'grains in the box'),
        ('part', ctypes.c_int, 'of these, grains of the component'),
        ('cells', ctypes.c_int, 'cells with at least one grain'),
        ('fraction', ctypes.c_double, 'part/grains'),
        ('variance', ctypes.c_double, "variance of the component's fraction over the cells, weighted by their grains"),
        ('variance_segregated', ctypes.c_double, 'variance of cells that hold one component each'),
        ('variance_random', ctypes.c_double, 'variance of a random mixture'),
        ('lacey', ctypes.c_double, '[LAC54]: 0 segregated, 1 random, above 1 more regular than random'),
        ('kramer', ctypes.c_double, "Kramer's index, the same with standard deviations instead of variances"),
        ('segregation', ctypes.c_double*3,
         'along x, y, z, and of the distance from the axis: 1 if the component is ahead of all others, 0 '
         'random, -1 if it is behind; random mixtures deviate by sqrt((N + 1)/(3 Na Nb))'),
        ('segregation_radial', ctypes.c_double, None),
        ('contacts', ctypes.c_int, 'between grains in the box; -1: no list (World.contacts)'),
        ('contact_segregation', ctypes.c_double, '1: no contact between the components, 0 random; needs a list'),
    ]


@_struct
class Repose(Struct):
    """The slope of a free surface, against gravity."""
    c_name = 'dem_repose'
    rows = [
        ('angle', ctypes.c_double, 'rad, of the straight line fitted to the surface'),
        ('error', ctypes.c_double, 'rad, its standard error'),
        ('places', ctypes.c_int, 'points of the fit: strips that are a mean diameter wide'),
    ]


@_struct
class MeshHealth(Struct):
    """Defects of a mesh, as counted on reading. They never stop a run."""
    c_name = 'dem_mesh_health'
    rows = [
        ('open_edges', ctypes.c_int, 'edges with one triangle'),
        ('crowded_edges', ctypes.c_int, 'edges with more than two triangles'),
        ('duplicates', ctypes.c_int, 'triangles with the same three corners as an earlier one'),
        ('shells', ctypes.c_int, 'pieces that are connected by edges with two triangles'),
        ('flipped', ctypes.c_int, 'triangles that face another way than most of their shell'),
        ('twisted_edges', ctypes.c_int, 'edges of shells that have one side only, like a Moebius strip'),
        ('slivers', ctypes.c_int, 'triangles: height below 1e-3 of the longest side, or no area'),
        ('merged_vertices', ctypes.c_int, 'vertices merged on reading, because they were equal (STL)'),
        ('split_faces', ctypes.c_int, 'faces of more than three corners, cut into triangles (OBJ)'),
        ('bent_faces', ctypes.c_int, 'of these: a corner is off their plane by > 1e-3 of their size'),
        ('crossed_faces', ctypes.c_int, 'of these: an edge crosses another, or they have no area'),
        ('box', Box, 'm, bounds of the mesh'),
        ('hint', Text(200), 'a likely mistake of units, or ""'),
    ]


@_struct
class SpheresFit(Struct):
    """The mass properties of a closed mesh, and how well spheres fit it."""
    c_name = 'dem_spheres_fit'
    rows = [
        ('volume', Real, 'm3, of the mesh, exact'),
        ('centre', Vec3, 'm, centre of mass of the mesh, exact'),
        ('inertia', Real*6, 'm5, of the mesh, exact, as in ClusterDesc'),
        ('volume_error', Real, 'volume of the union of spheres over that of the mesh, less 1'),
        ('inertia_error', Real, 'the same of the moment that deviates most; computed on the grid'),
        ('surface_error', Real, 'm, root mean square distance of the mesh from the union'),
        ('wrong', Real, 'volume in only one of the two, over that of the mesh'),
    ]


@_struct
class WallPart(Struct):
    """A named part of a file that becomes a wall."""
    c_name = 'dem_wall_part'
    rows = [
        ('name', str, 'as for World.mesh_part_read'),
        ('material', Material, ''),
        ('motion', Motion, 'Motion(): the wall stays where it is'),
    ]


@_struct
class Grains(Struct):
    """Spheres, as read from a file. Arrays for which the file has no data are None."""
    c_name = 'dem_grains'
    counts = {'count': (('positions', 3), ('radii', 1), ('velocities', 3), ('spins', 3), ('materials', 1))}
    rows = [
        ('count', ctypes.c_int, ''),
        ('positions', View(Real, 'count', 3), 'm, count x 3'),
        ('radii', View(Real, 'count'), 'm, count'),
        ('velocities', View(Real, 'count', 3), 'm/s, count x 3'),
        ('spins', View(Real, 'count', 3), 'rad/s, count x 3'),
        ('materials', View(ctypes.c_int32, 'count'), 'count: numbers of the file, 1: the first material added'),
        ('lines_left', ctypes.c_int, 'dumps and XYZ: lines of later frames, which are not read'),
        ('ignored', Text(240), 'names of columns without use, or ""'),
    ]


def _wrap_dem_replay_desc_number_fn(function, context, struct):

    def call(world, body, user):
        try:
            result = _real_from(function(context.world(world), body), 'number')
            return result
        except BaseException as error:
            context.fail(error)
            return _NAN
    return ctypes.cast(ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_void_p, Body, ctypes.c_void_p)(call), ReplayDescNumberFn.c)


ReplayDescNumberFn = Function(_wrap_dem_replay_desc_number_fn, ctypes.c_double, ctypes.c_void_p, Body, ctypes.c_void_p)
ReplayDescNumberFn.__doc__ = 'returns the number of a body, for every frame; None means one of World(body_reals=...)'


@_struct
class ReplayDesc(Struct):
    """How a replay is recorded."""
    c_name = 'dem_replay_desc'
    rows = [
        ('title', str, 'copied; None means the name of the file'),
        ('number', str,
         'Name of the numbers by which grains can be coloured: one in World(body_reals=...), a group in '
         'World(groups=...) (1: member, 0: not), or one for the values of number_fn. None means the first '
         'name, or "number". Copied, at most 63 characters.'),
        ('number_fn', ReplayDescNumberFn,
         'returns the number of a body, for every frame; None means one of World(body_reals=...)'),
        ('user', ctypes.c_void_p, 'passed to number_fn; or None'),
        ('resolution', Real, 'm, >= 0, of positions; 0 means 1/32 of the smallest radius in the first frame'),
        ('interval', ctypes.c_double,
         's, >= 0: a run writes frames automatically, the first when it begins and then at the steps nearest '
         'to multiples of the interval. A frame that cannot be written ends the replay, not the run: '
         'Replay.close returns the error. 0 means frames only from Replay.frame_write.'),
        ('contacts', ctypes.c_int,
         '>= 0: n records the contact forces in every n-th frame. The viewer draws them as lines between '
         'centres, or from a centre to the contact point with a wall, wider and redder for larger forces. A '
         'frame has at most the 50,000 largest, and none below 1 % of its largest. 0 means none.'),
    ]


@_struct
class Output(Id):
    """A scheduled output."""
    c_name = 'dem_output'
    rows = [
        ('id', ctypes.c_int32, ''),
    ]

    def remove(self):
        """Ends an output; files that it has written stay. Its id is never used again. To change an output, remove it and
        add another. The function of an output may remove any output, also its own.
        """
        self.world._ok(_lib.dem_output_remove(self.world._c, self))


def _wrap_dem_output_desc_values(function, context, struct):
    values_type = ctypes.c_double*(len((struct.columns or '').split()))

    def call(world, values, user):
        try:
            _values = values_type.from_address(values) if values else values_type()
            result = function(context.world(world), _values)
            if result is not None:
                raise _returned(result, 'values')
            if _refs(_values) > _ONE and _held(_values):
                raise _kept('values', 'values')
        except BaseException as error:
            context.fail(_beyond(error, 'values', values=values_type) if type(error) is IndexError else error)
            Real.from_address(values).value = _NAN
    return ctypes.cast(ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p)(call), OutputDescValues.c)


OutputDescValues = Function(_wrap_dem_output_desc_values, None, ctypes.c_void_p, ctypes.POINTER(ctypes.c_double), ctypes.c_void_p)
OutputDescValues.__doc__ = ''


def _wrap_dem_output_desc_function(function, context, struct):

    def call(world, number, user):
        try:
            result = int(bool(function(context.world(world), number)) or context.raised is not None)
            return result
        except BaseException as error:
            context.fail(error)
            return 1
    return ctypes.cast(ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_int64, ctypes.c_void_p)(call), OutputDescFunction.c)


OutputDescFunction = Function(_wrap_dem_output_desc_function, ctypes.c_int, ctypes.c_void_p, ctypes.c_int64, ctypes.c_void_p)
OutputDescFunction.__doc__ = 'kind "call": may change the world, but not step it. A return value other than 0 stops the run (StoppedError).'


@_struct
class OutputDesc(Struct):
    """How an output works."""
    c_name = 'dem_output_desc'
    uses = {'wall': (('kind', ('csv',)),), 'columns': (('kind', ('csv',)),), 'values': (('kind', ('csv',)),),
            'mixing': (('kind', ('csv',)),), 'outlet': (('kind', ('csv',)),), 'function': (('kind', ('call',)),),
            'field': (('kind', ('field_csv',)),), 'z0': (('kind', ('walls',)),), 'z1': (('kind', ('walls',)),)}
    required = ('interval',)
    rows = [
        ('kind', OutputKind, ''),
        ('path', str,
         'Name of the file, copied. In "grains_####.vtp" the number of the output replaces ####; it is 0 at '
         '`start`. Without # the file is replaced each time. The path of a CSV file has no #. "call": or None.'),
        ('interval', ctypes.c_double, 's, required, 1e-12 to 1e15'),
        ('start', ctypes.c_double, 's, times of the first and the last; end 0 means no last'),
        ('end', ctypes.c_double, None),
        ('wall', Wall,
         'kind "csv": what a line contains. One of five: the loads of this wall, as Wall.loads_csv_write; the '
         'counts of an outlet; the mixing of two components, if mixing.cells are set; the values that `values`'
         ' writes, with `columns` as their names (1 to 32 words as in body_reals, copied); or, if none of '
         'these is set, steps, bodies, contacts, kinetic and rotational energy (J) and overlap_max'),
        ('columns', str, ''),
        ('values', OutputDescValues, ''),
        ('function', OutputDescFunction,
         'kind "call": may change the world, but not step it. A return value other than 0 stops the run '
         '(StoppedError).'),
        ('user', ctypes.c_void_p, 'passed to `values` and `function`; or None'),
        ('mixing', MixingDesc, 'kind "csv": see above'),
        ('field', Field, 'kind "field_csv": required'),
        ('z0', Real,
         'm, kind "walls": profiles are extruded from z0 to z1 (z0 <= z1). If they are equal, as with '
         'World.output_every: over World(thickness=...) (planar), over World(domain=...) along z if it has an '
         'extent, or else from the lowest to the highest body'),
        ('z1', Real, None),
        ('outlet', Outlet,
         'kind "csv": grains that the outlet has counted (total, sorted, gangue, back, held) and their mass, '
         'kg, as in OutletState'),
    ]


def _wrap_dem_transport_exchange_fn(function, context, struct):

    def call(to_lower, to_lower_size, from_lower, from_lower_size, to_upper, to_upper_size, from_upper, from_upper_size, user):
        try:
            result = int(bool(function(to_lower, to_lower_size, from_lower, from_lower_size, to_upper, to_upper_size, from_upper, from_upper_size)) or context.raised is not None)
            return result
        except BaseException as error:
            context.fail(error)
            return 1
    return ctypes.cast(ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p)(call), TransportExchangeFn.c)


TransportExchangeFn = Function(_wrap_dem_transport_exchange_fn, ctypes.c_int, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p)
TransportExchangeFn.__doc__ = 'Sends to the process below and to the one above, and receives from both. Sizes are in bytes, known on both ends, and may be 0. Both neighbours may be the same process: what it sends up then arrives from below.'


def _wrap_dem_transport_reduce_fn(function, context, struct):

    def call(values, count, sum, user):
        try:
            result = int(bool(function(ctypes.cast(values, ctypes.POINTER(ctypes.c_double*count))[0], count, sum)) or context.raised is not None)
            return result
        except BaseException as error:
            context.fail(error)
            return 1
    return ctypes.cast(ctypes.CFUNCTYPE(ctypes.c_int, ctypes.POINTER(ctypes.c_double), ctypes.c_int, ctypes.c_int, ctypes.c_void_p)(call), TransportReduceFn.c)


TransportReduceFn = Function(_wrap_dem_transport_reduce_fn, ctypes.c_int, ctypes.POINTER(ctypes.c_double), ctypes.c_int, ctypes.c_int, ctypes.c_void_p)
TransportReduceFn.__doc__ = 'Replaces each of `count` values by its sum (sum = 1) or maximum (sum = 0) over processes.'


@_struct
class Transport(Struct):
    """How slabs in different processes communicate; all zero for a single process. Processes form a ring in the order of
    their slabs (the last is below the first), and make the same calls in the same order. Both functions return 0, or
    another value to stop the run; slabs cannot be used after that. docs/parallel.md shows both for MPI.
    """
    c_name = 'dem_transport'
    rows = [
        ('exchange_fn', TransportExchangeFn,
         'Sends to the process below and to the one above, and receives from both. Sizes are in bytes, known '
         'on both ends, and may be 0. Both neighbours may be the same process: what it sends up then arrives '
         'from below.'),
        ('reduce_fn', TransportReduceFn,
         'Replaces each of `count` values by its sum (sum = 1) or maximum (sum = 0) over processes.'),
        ('user', ctypes.c_void_p, 'passed to both; or None'),
    ]


@_struct
class SlabsDesc(Struct):
    """How a scene is divided."""
    c_name = 'dem_slabs_desc'
    required = ('count',)
    rows = [
        ('axis', ctypes.c_int, '0, 1, 2: borders are planes x, y, z = const'),
        ('count', ctypes.c_int,
         'required, 1 to 1024: number of slabs in all processes; only runs with the same number have the same '
         'bits'),
        ('first', ctypes.c_int, 'this process holds the slabs first to first + local - 1; local 0 means all'),
        ('local', ctypes.c_int, None),
        ('transport', Transport, 'required if another process holds slabs'),
        ('balance', Real,
         'borders move if the work of the busiest slab exceeds this many times the mean, >= 1; 0 means 1.1. '
         'Below 0 borders do not move.'),
        ('balance_interval', ctypes.c_int, 'rebuilds between two checks of the balance; 0 means 8'),
    ]


@_struct
class Slab(Struct):
    """One slab."""
    c_name = 'dem_slab'
    rows = [
        ('grains', ctypes.c_int, 'its own grains'),
        ('ghosts', ctypes.c_int, 'copies of grains of the lower neighbour'),
        ('lo', ctypes.c_double, 'm, its borders; -1e300, 1e300: none on that side'),
        ('hi', ctypes.c_double, None),
        ('work', ctypes.c_double, 'candidates + 4 per body, at the last rebuild'),
        ('seconds', ctypes.c_double, 'wall time spent on it so far'),
        ('bytes', ctypes.c_uint64, 'sent to its neighbours so far, as if in other processes'),
    ]


@_struct
class SlabsCounters(Struct):
    """Counters of slabs."""
    c_name = 'dem_slabs_counters'
    rows = [
        ('time', ctypes.c_double, 's, simulated'),
        ('steps', ctypes.c_uint64, ''),
        ('rebuilds', ctypes.c_uint64, ''),
        ('border_moves', ctypes.c_uint64, ''),
        ('migrated', ctypes.c_uint64, 'grains that changed slabs, in this process'),
        ('skin', Real, 'm, in use'),
        ('dt', Real, 's, in use'),
    ]


@_struct
class Effect(Struct):
    """An effect of the scene, such as friction, walls or the ledger."""
    c_name = 'dem_effect'
    rows = [
        ('name', str, ''),
        ('state', EffectState, ''),
        ('share', ctypes.c_double, 'fraction of the time of a step that is saved without the effect'),
        ('error', ctypes.c_double, 'its standard error'),
        ('measured', ctypes.c_int, '1: share was measured; 0: no budget, or it cannot be'),
        ('missing', ctypes.c_int,
         'number of pairs of materials, walls and the like that have the effect and that nothing has touched; '
         '0: everything in the scene has happened'),
        ('text', Text(200), 'what acts; why nothing acts; what has not happened'),
    ]


def _wrap_dem_contact_fn(function, context, struct):
    memory_type = _history(context.memory, context.vectors)
    contact_of = _read(ContactInfo).from_address

    def call(contact, memory, user):
        try:
            _contact = contact_of(contact)
            _memory = memory_type.from_address(memory) if memory else memory_type()
            function(_contact, _memory)
            if _refs(_contact) > _ONE and _held(_contact):
                raise _kept('contact', 'contact')
            if _refs(_memory) > _ONE and _held(_memory):
                raise _kept('memory', 'contact')
        except BaseException as error:
            context.fail(_beyond(error, 'contact', memory=memory_type) if type(error) is IndexError else error)
    return ctypes.cast(ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p)(call), ContactFn.c)


ContactFn = Function(_wrap_dem_contact_fn, None, ctypes.POINTER(ContactInfo), ctypes.POINTER(Real), ctypes.c_void_p)
ContactFn.__doc__ = 'Receives one contact and its history. memory: as many reals as World(law_memory=...), and one more if a pair has static friction, which is 1 while the contact slides (built-in laws: 0 to 10 in all; impulses: 17); vectors as seen from a. Values that the function writes there count from the next step on.'


structs = [Vec3, Box, Quat, Pose, Material, Wall, Field, Group, Shape, Body, ContactWho, Contact, ContactEnergy, ContactForce, Allocator, ContactRows, WorldDesc, MaterialDesc, Pair, Coefficients, Region, Sizes, BodyState, Bodies, Selection, BodiesMeans, ClusterDesc, ShapeInfo, Ellipsoid, EllipsoidContact, BodyCounts, MotionRow, Motion, Mesh, Profile, SieveDesc, WallLoads, Joint, JointDesc, JointState, RailDesc, RailState, Feed, Outlet, FeedDesc, FeedState, OutletDesc, OutletState, Advice, Finding, CellDesc, CellState, Counters, Ledger, Totals, Observable, TrialsDesc, Trial, Trials, ContactInfo, Event, EventsDesc, Impacts, Wear, Servo, Stress, FieldDesc, FieldData, FieldCell, BodyMeans, MixingDesc, Mixing, Repose, MeshHealth, SpheresFit, WallPart, Grains, ReplayDesc, Output, OutputDesc, Transport, SlabsDesc, Slab, SlabsCounters, Effect]


class World(WorldBase):
    """A world: everything that one simulation consists of."""

    def __init__(self, *, gravity=None, domain=None, boundary=(), planar=0, thickness=0, normal_law=0,
            tangent_law=0, rolling_law=0, tension=0, friction_load=0, slider=0, convention=0, law=None, law_rows=None,
            law_user=None, law_memory=0, law_memory_names=None, law_vectors=0, law_stiffness=0, law_range=0,
            law_range_radii=0, law_who=0, law_rate=None, body_reals=None, body_reals_fn=None, body_reals_user=None,
            growth=None, growth_user=None, growth_interval=0, groups=None, force=None, body_force=None,
            force_user=None, integrator=0, dt=0, allow_large_dt=0, impact_speed=0, response=0, cone=0, solver=0,
            sweeps=0, tolerance=0, cold_start=0, unsolved_stops=0, search=0, skin=0, rotation=0, ellipsoid_overlap=0,
            cluster_contacts=0, orientations=0, overlap_stop=0, ledger=0, threads=0, allocator=None):
        """Creates an empty world. ArgumentError says which value is out of range.

        gravity: m/s2
        domain: m. Required on axes whose boundary is periodic or outflow, not needed on open axes. A periodic axis
            must be at least as long as four of the largest radii, two skins and two ranges of the law.
        boundary: of the faces on the axes x, y and z; one of "open", "periodic", "outflow"
        planar: 1 makes the world two-dimensional: bodies are discs and polygons that move in the plane z = 0 and
            rotate about z only. The z component of gravity is ignored.
        thickness: m, of discs and polygons along z; 0 means 1 m
        normal_law: one of "hertz", "linear", "hysteretic"
        tangent_law: one of "auto", "none", "viscous", "step", "spring", "mindlin", "mindlin_rescaled"
        rolling_law: one of "auto", "none", "step", "constant", "epsd"
        tension: one of "allowed", "clipped", "compensated"
        friction_load: one of "repulsive", "elastic", "magnitude"
        slider: one of "parallel", "spring", "remainder"
        convention: one of "standard", "mill"
        law: replaces the normal, tangential and rolling law; None means the laws above
        law_rows: The same law for rows of contacts of spheres, which is faster: DEM_LAW_ROWS defines it. It must
            return what law returns; dem.h uses whichever suits. It needs law. None means that law is called for each
            contact, as it always is with law_who.
        law_memory: reals of contact history per contact, 0 to 16
        law_memory_names: Names of these reals for World.contacts_vtp_write, written as in body_reals. None means
            memory0, memory1 and so on.
        law_vectors: leading triples of them that are vectors, 0 to law_memory/3
        law_stiffness: N/m, the largest stiffness of law; limits the time step. 0 means the stiffness of the built-in
            law.
        law_range: m, >= 0. law is also called for two bodies that do not touch while their gap is below law_range +
            law_range_radii (Ra + Rb), with c.overlap < 0. A wall counts with radius 0, an ellipsoid with its bounding
            sphere. Built-in laws that it calls need overlap > 0. 0 means no range. With both 0, law is called in
            contact only, at no extra cost.
        law_range_radii: >= 0; see law_range; 0 means no such range
        law_who: 1 fills in c.who: ids, radii, masses, contact point, time
        law_rate: Returns how fast law changes numbers on bodies; limits the time step. It needs law, law_who and
            body_reals. It is called before the first step and at least once in eight steps. A given dt above the
            stable limit is an error; a chosen dt is at most half of it. None means that these rates do not limit dt.
        body_reals: Names of numbers that every body and wall carries, such as "temperature charge": at most 8 words
            of up to 23 letters, digits and _. Files use these names. The numbers begin as 0. With law_who, law reads
            them and returns their rates (per s). None means no numbers.
        body_reals_fn: Updates the numbers of a body after each step. None means that each grows by rate dt. Numbers
            of walls stay as set; WallLoads sums what they would gain.
        growth: Returns the rate of the radius of a body, m/s: > 0 grows, < 0 wears. Mass follows at constant density,
            velocity and contact history stay. Each change of radii costs a new list and another computation of
            forces. None means constant radii; see Body.radius_set.
        growth_interval: s, between two changes of radii; 0 means every step. A body that was added within an interval
            grows for all of it. In single precision changes below 6e-8 of a radius are lost: take a longer interval
        groups: Names of sets of bodies, such as "coarse tracer": at most 32 words of up to 23 letters, digits and _.
            A body belongs to none until World.bodies_group_set. None means no groups.
        force: force on a body; None means none
        body_force: force and torque on a body; None means none
        integrator: one of "velocity_verlet", "forward_euler", "symplectic_euler", "position_verlet", "leapfrog"
        dt: s, the time step; 0 means chosen from the scene, see World.step_advice
        allow_large_dt: 1 allows dt above the stable limit, to show what happens then. It switches off all checks of
            the step: of contacts, speeds, walls and law_rate; a chosen dt is not shortened either.
        impact_speed: m/s, typical impact speed. The time step and, in the linear and hysteretic law, a stiffness from
            Young's modulus depend on it. 0 means the largest speed expected from grains, walls and height of fall for
            the time step, and 1 m/s for the stiffness.
        response: "impulses" needs dt > 0 and law None. Its steps are of second order (docs/impulses.md) for either
            value of integrator that it accepts, 0 and "symplectic_euler". law_range (m) is then the gap below which
            contacts are solved. If it is 0, dem.h takes three times the distance that the fastest point of a body or
            wall moves in a step, at most the largest radius R and at least 0.01 R. On a periodic axis of length P it
            is at most the larger of 0.1 R and 0.8 (P/2 - 2 R - skin), with skin 0 unless you set it. The fields that
            follow apply to impulses only. One of "springs", "impulses"
        cone: one of "coulomb", "convex"
        solver: one of "gauss_seidel", "jacobi", "apgd", "spectral"
        sweeps: most sweeps over all contacts in a step; 0 means 200
        tolerance: m/s. The sweeps end when no contact changes its velocity by more in one sweep. 0 means when the
            root mean square change is below 0.05 g dt plus 1e-5 of the largest speed, and the largest change is below
            30 times that. Where polyhedra lie on faces, and in towers of more than three bodies, the root mean square
            must also fall to a tenth of that and to half of its first value, or to 1e-5 of that (single precision:
            3e-4).
        cold_start: 1 begins with zero impulses, not those of the last step
        unsolved_stops: 1 ends the run with StoppedError after a step whose sweeps did not reach the tolerance. With 0
            it continues; World.counters, the report and World.progress_print count such steps.
        search: one of "auto", "all_pairs", "grid", "linked_list", "hierarchical", "bins"
        skin: m, margin of the neighbour list; 0 means chosen for speed; < 0 means none: the list is rebuilt in every
            step.
        rotation: one of "spiral", "fincham", "no_squish"
        ellipsoid_overlap: one of "conservative", "chord", "normal"
        cluster_contacts: one of "merged", "separate"
        orientations: 1 follows the orientations of spheres too
        overlap_stop: 0 to 1, in radii (see Counters.overlap_max): a step after which an overlap is larger ends the
            run with StoppedError, because grains are jammed or too soft. 0 means off. The report and
            World.progress_print name an overlap above 0.05.
        ledger: 1 accounts for energy, see World.ledger
        threads: Largest number of threads, 0 to 64; 0 means as many as OpenMP offers, at most 64. Fewer are used
            while that is faster; results are the same.
        allocator: memory functions; 0 means malloc and free
        """
        self._create(WorldDesc._of_call("World", dict(gravity=gravity, domain=domain, boundary=boundary,
            planar=planar, thickness=thickness, normal_law=normal_law, tangent_law=tangent_law,
            rolling_law=rolling_law, tension=tension, friction_load=friction_load, slider=slider,
            convention=convention, law=law, law_rows=law_rows, law_user=law_user, law_memory=law_memory,
            law_memory_names=law_memory_names, law_vectors=law_vectors, law_stiffness=law_stiffness,
            law_range=law_range, law_range_radii=law_range_radii, law_who=law_who, law_rate=law_rate,
            body_reals=body_reals, body_reals_fn=body_reals_fn, body_reals_user=body_reals_user,
            growth=growth, growth_user=growth_user, growth_interval=growth_interval, groups=groups,
            force=force, body_force=body_force, force_user=force_user, integrator=integrator, dt=dt,
            allow_large_dt=allow_large_dt, impact_speed=impact_speed, response=response, cone=cone,
            solver=solver, sweeps=sweeps, tolerance=tolerance, cold_start=cold_start,
            unsolved_stops=unsolved_stops, search=search, skin=skin, rotation=rotation,
            ellipsoid_overlap=ellipsoid_overlap, cluster_contacts=cluster_contacts,
            orientations=orientations, overlap_stop=overlap_stop, ledger=ledger, threads=threads,
            allocator=allocator)))

    @property
    def error(self):
        """Returns the error message of the last call on this world that failed; "" if none failed. Exceptions have it
        already.
        """
        return (_lib.dem_world_error_get(self._c) or b'').decode()

    @property
    def desc(self):
        """Returns the desc as given, with the present gravity, domain and dt, the search and integrator in use, and
        thickness and threads where they were 0. skin: present value; 0 before the first list or if World(skin=...) <
        0. Other zeros stay 0, such as laws, sweeps and tolerance.

        Returns: WorldDesc
        """
        found = _lib.dem_world_desc_get(self._c)
        self._ok(0)
        return self._with(found, _world_call)

    def material(self, *, density=0, young=0, poisson=0, restitution=0, friction=0, friction_static=0,
            rolling_friction=0, stiffness=0, stiffness_ratio=0, stiffness_unloading=0, stiffness_adhesion=0):
        """Adds a material. A world holds at most 64.

        density: kg/m3, required, > 0
        young: Pa, required, > 0; may be 0 with impulses, or if a linear or hysteretic law has a stiffness
        poisson: >= 0 and < 0.5: nu; 0 is a physical value
        restitution: Required, > 0 and <= 1: e, speed after a normal impact over speed before it; may be 0 with
            impulses. The hysteretic law takes either this or stiffness_unloading; they are related by e =
            sqrt(kn/kun) for a contact without adhesion.
        friction: sliding friction mu, >= 0
        friction_static: Static friction mu_s, >= friction; 0 means equal to friction. The limit of friction is mu_s
            Fn until the contact slides, then mu Fn until the slip stops or reverses.
        rolling_friction: mu_r, >= 0: the moment is at most mu_r R* Fn
        stiffness: N/m, kn of the linear and hysteretic law; 0 means from young and impact_speed [DIM04]
        stiffness_ratio: kt/kn of these two laws; 0 means 2(1 - nu)/(2 - nu)
        stiffness_unloading: N/m, kun of the hysteretic law, >= stiffness; 0 means from restitution. Needs stiffness.
        stiffness_adhesion: N/m, kad of the hysteretic law, >= 0 (a negative slope in [ALK07]); 0 means no adhesion
        Returns: Material
        """
        desc = MaterialDesc._of_call('World.material', dict(density=density, young=young, poisson=poisson,
            restitution=restitution, friction=friction, friction_static=friction_static,
            rolling_friction=rolling_friction, stiffness=stiffness, stiffness_ratio=stiffness_ratio,
            stiffness_unloading=stiffness_unloading, stiffness_adhesion=stiffness_adhesion))
        return self._id(_lib.dem_material_add(self._c, desc))

    def pair(self, a, b):
        """Returns the contact properties of two materials.

        Returns: Pair
        """
        pair = Pair()
        self._ok(_lib.dem_pair_get(self._c, a, b, pair))
        self._with(pair, 'call World.pair_set(...), which changes the fields that it is given')
        return pair

    def pair_set(self, a, b, *, young_eff=None, shear_eff=None, restitution=None, friction=None,
            friction_static=None, rolling_friction=None, stiffness=None, stiffness_ratio=None, tangent_damping=None,
            normal_damping=None, spinning_friction=None, cohesion=None, compliance=None, stiffness_adhesion=None,
            ignored=None):
        """Replaces the contact properties of two materials, in both orders. Start from World.pair.

        Fields that are not given stay as they are.
        young_eff: Pa, E*, > 0; may be 0 where `young` may
        shear_eff: Pa, G*
        restitution: > 0 and <= 1: e; may be 0 with impulses
        friction: sliding friction mu, >= 0
        friction_static: mu_s, >= friction; 0 means equal to friction, also when friction changes. Mixed: 0 if both
            materials leave it 0.
        rolling_friction: mu_r: the moment is at most mu_r R* Fn
        stiffness: N/m, linear and hysteretic law; 0 means from E* and impact_speed for each pair of radii
        stiffness_ratio: kt/kn, linear and hysteretic law
        tangent_damping: factor on the tangential dashpot, >= 0; mixed: 1
        normal_damping: N s/m, the normal dashpot of the linear and hysteretic law for all masses; 0 means from
            restitution (linear) or none (hysteretic)
        spinning_friction: mu_spin, >= 0: twisting friction, a moment about the normal up to mu_spin R* Fn; 0 when
            mixed. With springs: dem.law_twist.
        cohesion: N, >= 0: attractive force between bodies in contact. It holds until the gap exceeds 1e-3 of the
            smaller radius.
        compliance: m/N, >= 0: a spring of stiffness 1/compliance, evaluated at the end of the step. It is stable for
            any value; oscillations that the step does not resolve are damped.
        stiffness_adhesion: N/m, kad of the hysteretic law; its kun is stiffness/restitution^2
        ignored: 1: bodies and walls of these materials pass through each other. They make no contacts, and laws that
            act at a distance are not called for them. The energy of springs that are in contact when this is set goes
            to the residual of the ledger. Mixed: 0.
        """
        pair = _renamed(lambda: self.pair(a, b), 'World.pair', 'World.pair_set')
        pair._put({name: value for name, value in (('young_eff', young_eff), ('shear_eff', shear_eff), ('restitution',
            restitution), ('friction', friction), ('friction_static', friction_static), ('rolling_friction',
            rolling_friction), ('stiffness', stiffness), ('stiffness_ratio', stiffness_ratio), ('tangent_damping',
            tangent_damping), ('normal_damping', normal_damping), ('spinning_friction', spinning_friction),
            ('cohesion', cohesion), ('compliance', compliance), ('stiffness_adhesion', stiffness_adhesion),
            ('ignored', ignored),) if value is not None}, 'World.pair_set: ')
        self._ok(_lib.dem_pair_set(self._c, a, b, pair))

    def coefficients(self, a, b, radius_a, radius_b):
        """Computes the coefficients for spheres of radius_a and radius_b (m). radius_b = 0 means a wall of material b.
        The impact speed is that of the desc, or 1 m/s if it is 0 there.

        Returns: Coefficients
        """
        out = Coefficients()
        self._ok(_lib.dem_coefficients_get(self._c, a, b, radius_a, radius_b, out))
        self._with(out)
        return out

    def pairs_print(self, out=None):
        """Prints contact properties of all pairs of materials, one line per pair: moduli, restitution, friction and
        stiffness; with impulses also spinning friction, cohesion and compliance.
        """
        return self._print(_lib.dem_pairs_print, out, self._c)

    def sphere(self, material, radius, position):
        """Adds a sphere, or in a planar world a disc, at rest. radius > 0 and position in m.

        Returns: Body
        """
        return self._id(_lib.dem_sphere_add(self._c, material, radius, position))

    def spheres(self, material, positions, velocities=None, radii=None, radius=0):
        """Adds count spheres, all or none. positions: count x 3, m. velocities: count x 3, m/s, or None for rest. radii:
        count, m, or None if all have `radius`.
        """
        _one_radius(radii, radius, 'World.spheres: ')
        positions = _array_of(positions, Real, 'World.spheres: positions', 3)
        count = len(positions)//3
        velocities = _array_of(velocities, Real, 'World.spheres: velocities', 3, count, True)
        radii = _array_of(radii, Real, 'World.spheres: radii', 1, count, True)
        self._ok(_lib.dem_spheres_add(self._c, material, count, positions, velocities, radii, radius),
            dict(positions=positions, velocities=velocities, radii=radii))

    def spheres_fill(self, material, radius, region, count, seed):
        """Adds up to count spheres of one radius (m) at random positions in a region, one after the other. The same seed
        gives the same positions. A position is free if the sphere there overlaps no body (a body that is not a sphere
        counts with its bounding sphere), also across periodic faces, and touches no wall. What the material ignores
        (Pair) does not count. No position is free behind a plane, on the wrong side of a cylinder or in a sieve; the
        inside of a closed mesh counts like its outside. Returns how many were added. If these are fewer than count,
        2000 tries for one sphere failed; World.error says so, but the world can run.
        """
        return self._filled(_lib.dem_spheres_fill(self._c, material, radius, self._bound(_struct_of(Region, region,
            'World.spheres_fill: region')), count, seed), count, 'dem_spheres_fill')

    def sizes_finer(self, sizes, radius):
        """Returns the fraction finer than a radius (m), of mass or number as by_count says."""
        sizes = self._bound(_struct_of(Sizes, sizes, 'World.sizes_finer: sizes'))
        return self._number(_lib.dem_sizes_finer_get(self._c, sizes, radius))

    def sizes_draw(self, sizes, count, seed):
        """Draws count radii (m) at random or, with seed 0, at equal steps of the distribution of numbers, ascending:
        then a few hundred radii represent it within 1 %. Mass is proportional to r^3, in planar worlds to r^2.

        Returns: Row
        """
        sizes = self._bound(_struct_of(Sizes, sizes, 'World.sizes_draw: sizes'))
        radii = _row(Real, _size_of(count, 'World.sizes_draw: count'))()
        self._ok(_lib.dem_sizes_draw(self._c, sizes, count, seed, ctypes.cast(radii, ctypes.POINTER(Real))))
        return radii

    def sizes_classes(self, sizes, class_count):
        """Divides a distribution into at most class_count (1 to 16) classes, whose bounds have equal ratios, for the
        fields radius and amount of FeedDesc (with by_mass = 1 - by_count). radius (m) is that of a grain of the mean
        mass of its class; the amounts sum to 1. Returns the radii and the amounts of the classes that are not empty.
        """
        sizes = self._bound(_struct_of(Sizes, sizes, 'World.sizes_classes: sizes'))
        radius = _row(Real, _size_of(class_count, 'World.sizes_classes: class_count'))()
        amount = _row(ctypes.c_double, _size_of(class_count, 'World.sizes_classes: class_count'))()
        found = _lib.dem_sizes_classes_get(self._c, sizes, class_count, ctypes.cast(radius, ctypes.POINTER(Real)),
            ctypes.cast(amount, ctypes.POINTER(ctypes.c_double)))
        self._filled(found, 0, 'dem_sizes_classes_get')
        return list(radius[:found]), list(amount[:found])

    def sizes_fill(self, material, sizes, region, count, seed):
        """Adds up to count spheres, as World.spheres_fill does, with radii as World.sizes_draw gives them for its seed
        0, largest first, while there is most room. seed is for the positions.
        """
        sizes = self._bound(_struct_of(Sizes, sizes, 'World.sizes_fill: sizes'))
        return self._filled(_lib.dem_sizes_fill(self._c, material, sizes, self._bound(_struct_of(Region, region,
            'World.sizes_fill: region')), count, seed), count, 'dem_sizes_fill')

    def spheres_pack(self, material, radius, padding, region, count=0):
        """Adds spheres on a hexagonal close packing, in layers along z, with a gap of padding (m, >= 0) between
        surfaces: at most count (0: all that fit), at those sites that lie in the region and are free as in
        World.spheres_fill. In a planar world the packing is a triangular lattice. Spheres at opposite periodic faces
        do not overlap, but the lattice does not continue across the faces. Returns how many were added.
        """
        return self._filled(_lib.dem_spheres_pack(self._c, material, radius, padding, self._bound(_struct_of(Region,
            region, 'World.spheres_pack: region')), count), count, 'dem_spheres_pack')

    @property
    def temperature(self):
        """Returns the granular temperature, m2/s2: the mass-weighted mean square deviation of velocities from their
        mean, per axis (two in a planar world), over all bodies that can move. Returns 0 for fewer than two bodies.
        """
        found = _lib.dem_temperature_get(self._c)
        self._ok(0)
        return found

    def temperature_set(self, temperature, seed=0):
        """Sets the granular temperature (m2/s2, >= 0). seed 0 scales the deviations from the mean velocity; any other
        seed draws velocities from Maxwell's distribution, with equal mean energy for all masses. The mean velocity
        and the spins stay. It is an error if fewer than two bodies can move, or if seed is 0 and the present
        temperature is 0.
        """
        self._ok(_lib.dem_temperature_set(self._c, temperature, seed))

    @property
    def bodies_memory(self):
        """Returns the arrays of all bodies.

        Returns: Bodies
        """
        found = _lib.dem_bodies_get(self._c)
        self._ok(0)
        return self._with(found)

    def body_id(self, index):
        """Returns the id of the body at this index of the arrays.

        Returns: Body
        """
        return self.bodies[index]

    def group(self, name):
        """Returns the group with this name in World(groups=...).

        Returns: Group
        """
        if not self.desc.groups:
            raise _no_groups(name)
        found = _lib.dem_group_get(self._c, _text_of(name, 'World.group: name'))
        self._ok(0)
        if not found:
            self._raise(ArgumentError)
        found._of = self
        return found

    def bodies_select(self, selection):
        """Returns the ids of the selected bodies, in the order of their slots. Selections are made between steps: laws
        and other functions that a step calls cannot make them.

        Returns: a list of Body
        """
        selection = self._bound(_struct_of(Selection, selection, 'World.bodies_select: selection'))
        capacity = self._number(_lib.dem_bodies_select(self._c, selection, None, 0))
        out = _row(Body, max(capacity, 1))()
        count = self._number(_lib.dem_bodies_select(self._c, selection, ctypes.cast(out, ctypes.POINTER(Body)),
            capacity))
        array = _row(out._type_, count).from_buffer(out)
        return [item.of(self) for item in array]

    def bodies_group_set(self, selection, group, member):
        """Makes the selected bodies members of a group (member = 1), or takes them out (0). A body may be in many
        groups. Members stay members when bodies are sorted, restarted or dealt to slabs. Returns how many bodies are
        selected.
        """
        selection = self._bound(_struct_of(Selection, selection, 'World.bodies_group_set: selection'))
        return self._number(_lib.dem_bodies_group_set(self._c, selection, group, member))

    def bodies_velocity_set(self, selection, velocity, spin):
        """Gives the selected bodies a velocity (m/s) and a spin (rad/s), as Body.set does. Returns their number."""
        selection = self._bound(_struct_of(Selection, selection, 'World.bodies_velocity_set: selection'))
        return self._number(_lib.dem_bodies_velocity_set(self._c, selection, velocity, spin))

    def bodies_fixed_set(self, selection, fixed):
        """Freezes the selected bodies (fixed = 1), which then never move, or frees them (0). Returns their number."""
        selection = self._bound(_struct_of(Selection, selection, 'World.bodies_fixed_set: selection'))
        return self._number(_lib.dem_bodies_fixed_set(self._c, selection, fixed))

    def bodies_remove(self, *, group=None, material=None, shape=None, radius_min=0, radius_max=0, region=None,
            count=0, bodies=None):
        """Removes the selected bodies, with one new list for all. Returns their number.

        group: only members of this group; None means any
        material: only of this material; None means any
        shape: only of this shape; None means any, spheres included
        radius_min, radius_max: m, only of these (bounding) radii; max 0 means no limit
        region: Only bodies whose centre is in this region, or on a periodic axis one of its images. None means
            anywhere.
        bodies: Only these; ids of bodies that are gone do not count. None means any.
        """
        selection = Selection._of_call('World.bodies_remove', dict(group=group, material=material, shape=shape,
            radius_min=radius_min, radius_max=radius_max, region=region, count=count, bodies=bodies))
        selection = self._bound(selection)
        return self._number(_lib.dem_bodies_remove(self._c, selection))

    def bodies_means(self, *, group=None, material=None, shape=None, radius_min=0, radius_max=0, region=None,
            count=0, bodies=None):
        """Returns the sums and means of the selected bodies.

        group: only members of this group; None means any
        material: only of this material; None means any
        shape: only of this shape; None means any, spheres included
        radius_min, radius_max: m, only of these (bounding) radii; max 0 means no limit
        region: Only bodies whose centre is in this region, or on a periodic axis one of its images. None means
            anywhere.
        bodies: Only these; ids of bodies that are gone do not count. None means any.
        Returns: BodiesMeans
        """
        means = BodiesMeans()
        selection = Selection._of_call('World.bodies_means', dict(group=group, material=material, shape=shape,
            radius_min=radius_min, radius_max=radius_max, region=region, count=count, bodies=bodies))
        selection = self._bound(selection)
        self._ok(_lib.dem_bodies_means_get(self._c, selection, means))
        self._with(means)
        return means

    def bodies_reals_set(self, reals):
        """The numbers (World(body_reals=...)) of all bodies, count x real_count: sets them, in the order of
        world.bodies. Values must be finite. Laws use them from the next step on. It is an error if the world has no
        names of such numbers.
        """
        reals = _array_of(reals, Real, 'World.bodies_reals_set: reals', self._context.reals, self.bodies.count)
        reals = self.bodies._in_memory(reals, self._context.reals)
        self._ok(_lib.dem_bodies_reals_set(self._c, reals))

    def shape_ellipsoid(self, semi_axes):
        """Adds an ellipsoid with these semi-axes (m, > 0) along x, y and z of its frame. The longest may be at most 1000
        times the shortest. Not in planar worlds.

        Returns: Shape
        """
        return self._id(_lib.dem_shape_ellipsoid_add(self._c, semi_axes))

    def shape_cluster(self, *, count=0, positions=None, radii=None, radius=0, mass=0, rays=0, volume=0,
            centre=None, inertia=()):
        """Adds a cluster and computes its principal axes. Not in planar worlds.

        positions: m, required: count x 3
        radii: m, > 0: one each; None means that all have `radius`
        radius: m, of all spheres if radii is None
        mass: one of "union", "sum", "given"
        rays: "union": rays per side of the outline, 16 to 4096; 0 means 512. It is an error if rays are more than a
            quarter of the smallest radius apart.
        volume: m3. The rest is for "given".
        centre: m, centre of mass
        inertia: m5, moments of inertia about the centre per density: xx, yy, zz, xy, xz, yz. Off-diagonal ones are
            elements of the tensor: xy is -(integral of x y).
        Returns: Shape
        """
        desc = ClusterDesc._of_call('World.shape_cluster', dict(count=count, positions=positions, radii=radii,
            radius=radius, mass=mass, rays=rays, volume=volume, centre=centre, inertia=inertia))
        return self._id(_lib.dem_shape_cluster_add(self._c, desc))

    def shape_polyhedron(self, points):
        """Adds a convex polyhedron: the convex hull of points (count x 3, m, 4 to 10,000), in a frame of your choice.
        Points inside the hull, or within 1e-10 of its size (single precision: 1e-6) of a face, are dropped. If more
        than dem.POLYHEDRON_FACES faces remain, this tolerance is raised up to 1e-5. It is an error if still more
        remain, or if the points lie in a plane. Not in planar worlds. Two polyhedra repel each other by a pressure
        field in the volume they share ([ELA19]), a polyhedron and a sphere or ellipsoid at the nearest point.
        World.contacts reports a contact of two polyhedra, or of one with a wall, as four points over which its force
        is spread; counters count it once. With impulses it has up to four points, each with its own gap; counters
        count the points with a repulsive force.

        Returns: Shape
        """
        points = _array_of(points, Real, 'World.shape_polyhedron: points', 3)
        count = len(points)//3
        return self._id(_lib.dem_shape_polyhedron_add(self._c, count, points))

    def shape_mesh(self, mesh, dent=0):
        """Adds the convex hull of a mesh (World.mesh_read: STL, OBJ). It is an error, which says where, if the mesh lies
        deeper inside its hull than dent (m, >= 0; 0 accepts convex meshes only, up to round-off). The mesh must bound
        a body, as for World.mesh_spheres; for an open mesh pass its vertices to World.shape_polyhedron. Not in planar
        worlds.

        Returns: Shape
        """
        mesh = self._bound(_struct_of(Mesh, mesh, 'World.shape_mesh: mesh'))
        return self._id(_lib.dem_shape_mesh_add(self._c, mesh, dent))

    def shape_union(self, shapes, positions=None, orientations=None):
        """Adds a union: count (1 to 1000) polyhedra, polygons or ellipsoids as one rigid body, in a frame of your
        choice. Each piece is a shape of this world, with a position (count x 3, m) and an orientation (count x 4;
        None means none is rotated). Mass, moments and contact forces are the sums over the pieces: overlapping pieces
        count twice. Clusters and unions cannot be pieces.

        Returns: Shape
        """
        shapes = _array_of(shapes, Shape, 'World.shape_union: shapes', 1)
        count = len(shapes)
        positions = _array_of(positions, Real, 'World.shape_union: positions', 3, count, True)
        orientations = _array_of(orientations, Real, 'World.shape_union: orientations', 4, count, True)
        return self._id(_lib.dem_shape_union_add(self._c, count, shapes, positions, orientations))

    def shape_polygon(self, points):
        """Adds a polygon in a planar world: corners in sequence, clockwise or anticlockwise (count x 2, m, 3 to 98). A
        concave polygon becomes the union of convex pieces, which are shapes too. The mass is density x area x
        World(thickness=...). For contacts the polygon is a prism of thickness 4/3 sqrt(area/pi), which gives it the
        volume of the sphere with the same area of cross-section. It is an error if sides cross.

        Returns: Shape
        """
        points = _array_of(points, Real, 'World.shape_polygon: points', 2)
        count = len(points)//2
        return self._id(_lib.dem_shape_polygon_add(self._c, count, points))

    def body(self, material, shape, position, orientation=(1, 0, 0, 0)):
        """Adds a body of a shape at rest, with its centre of mass at position (m) and rotated by orientation (any length
        but 0) from the frame in which the shape was given. It is an error if a wall has no contact with this shape:
        "fraction" profiles and some sieves (SieveKind) have none with ellipsoids and polyhedra; sieves, cones and
        other surfaces of revolution have none with polygons.

        Returns: Body
        """
        return self._id(_lib.dem_body_add(self._c, material, shape, position, orientation))

    def bodies_add(self, material, shape, positions, orientations=None, velocities=None, spins=None,
            scales=None):
        """Adds count bodies of a shape, all or none. positions: count x 3, m. The other arrays may be None: orientations
        (count x 4: w, x, y, z; None: not rotated), velocities and spins (count x 3: m/s and rad/s in the world's
        frame; None: at rest), scales (count, > 0: factor on all lengths of the shape; None: 1).
        """
        positions = _array_of(positions, Real, 'World.bodies_add: positions', 3)
        count = len(positions)//3
        orientations = _array_of(orientations, Real, 'World.bodies_add: orientations', 4, count, True)
        velocities = _array_of(velocities, Real, 'World.bodies_add: velocities', 3, count, True)
        spins = _array_of(spins, Real, 'World.bodies_add: spins', 3, count, True)
        scales = _array_of(scales, Real, 'World.bodies_add: scales', 1, count, True)
        self._ok(_lib.dem_bodies_add(self._c, material, shape, count, positions, orientations, velocities, spins,
            scales), dict(positions=positions, orientations=orientations, velocities=velocities, spins=spins,
            scales=scales))

    def bodies_fill(self, material, shape, region, count, seed):
        """Adds up to count bodies of a shape in random orientations, as World.spheres_fill does. Bounding spheres do not
        overlap, so that every body is free to rotate.
        """
        return self._filled(_lib.dem_bodies_fill(self._c, material, shape, self._bound(_struct_of(Region, region,
            'World.bodies_fill: region')), count, seed), count, 'dem_bodies_fill')

    @property
    def body_counts(self):
        """Returns the numbers of bodies.

        Returns: BodyCounts
        """
        found = _lib.dem_body_counts_get(self._c)
        self._ok(0)
        return self._with(found)

    def wall_plane(self, material, point, normal):
        """Adds a plane through point (m). Grains are on the side to which normal points.

        Returns: Wall
        """
        return self._id(_lib.dem_wall_plane_add(self._c, material, point, normal))

    def wall_cylinder(self, material, point, axis, radius, inside):
        """Adds an infinite cylinder of radius (m) about an axis through point (m). Grains are inside if inside = 1, and
        outside if inside = 0.

        Returns: Wall
        """
        return self._id(_lib.dem_wall_cylinder_add(self._c, material, point, axis, radius, inside))

    def wall_revolved(self, material, point, axis, radii, heights):
        """Adds a surface of revolution about an axis through point (m): straight pieces between count (2 to dem.RINGS)
        rings of these radii (m, >= 0) at these heights (m, along the axis from point). It can be a finite cylinder, a
        cone, a disc with a hole, a tube with a funnel or a drum with its ends. Both sides repel. In an inner corner a
        grain touches both pieces; at an outer corner and at a rim it touches the ring. A grain too wide for a narrow
        part touches one side of it only. Ellipsoids and, with springs, polyhedra touch facets in its place. Polygons
        have no contact with it; use a profile.

        Returns: Wall
        """
        radii = _array_of(radii, Real, 'World.wall_revolved: radii', 1)
        count = len(radii)
        heights = _array_of(heights, Real, 'World.wall_revolved: heights', 1, count, False)
        return self._id(_lib.dem_wall_revolved_add(self._c, material, point, axis, count, radii, heights))

    def wall_cone(self, material, from_, to, radius_from, radius_to):
        """Adds one piece of a surface of revolution: an open cone between two points (m) with these radii (m, >= 0, not
        both 0). Equal radii make a finite cylinder.

        Returns: Wall
        """
        return self._id(_lib.dem_wall_cone_add(self._c, material, from_, to, radius_from, radius_to))

    def wall_profile(self, material, profile, rule=0):
        """Adds a profile: segments in the x-y plane, extruded along z without end. Both sides repel.

        Returns: Wall
        """
        profile = self._bound(_struct_of(Profile, profile, 'World.wall_profile: profile'))
        return self._id(_lib.dem_wall_profile_add(self._c, material, profile, _enum_of(rule, EdgeRule,
            'World.wall_profile: rule')))

    def wall_mesh(self, material, mesh):
        """Adds a triangle mesh. Both sides repel. Meshes that do not move relative to each other act as one surface,
        however it is divided; so do profiles. A wall is at rest until its motion begins.

        Returns: Wall
        """
        mesh = self._bound(_struct_of(Mesh, mesh, 'World.wall_mesh: mesh'))
        return self._id(_lib.dem_wall_mesh_add(self._c, material, mesh))

    def wall_grains(self, material, positions, radius, share):
        """Adds a wall of spheres of one radius (m) at positions (count x 3, m), as in [MIL]. All forces are multiplied
        by share (0 < share <= 1), because overlapping spheres represent one surface.

        Returns: Wall
        """
        positions = _array_of(positions, Real, 'World.wall_grains: positions', 3)
        count = len(positions)//3
        return self._id(_lib.dem_wall_grains_add(self._c, material, count, positions, radius, share))

    def wall_sieve(self, material, *, kind=0, point=None, normal=None, along=None, aperture=0, bar=0,
            length=0, thickness=0, lift=0, staggered=0, radius=0, model=0, clearance=0):
        """Adds a sieve.

        kind: required; one of "none", "wires", "bars", "square", "round", "slots", "reduced"
        point: m, centre of a hole, at half the thickness
        normal: across the sieve; 0 means along z
        along: Direction of the rows of holes; 0 means along x, or y if x is near the normal. The same holds for a
            direction within 0.001 rad of the normal.
        aperture: m, required, > 0: clear width, side or diameter of a hole
        bar: m, required, > 0: wire diameter, or width between two holes
        length: m, of slots, >= aperture; 0 means infinite
        thickness: m, of plates; 0 means a sheet with sharp rims
        lift: m, between the axes of the two layers of wires; 0 means one plane. `bar` puts one layer on the other;
            real wires wind between the two.
        staggered: 1 puts round holes in a triangular pattern
        radius: m, of the disc; 0 means an infinite sieve
        model: Rule of reduced holes. A sphere smaller than the hole falls if its centre is within (1 - clearance) b
            of the middle of the hole in both directions: b = aperture/2 - radius (model 0 or 1) or aperture/2 (model
            2) [ALK07] eq 4.20, 4.21. Once it falls, it falls to the end.
        clearance: reduced holes: 0 open, 1 closed; zeta of [ALK07]
        Returns: Wall
        """
        desc = SieveDesc._of_call('World.wall_sieve', dict(kind=kind, point=point, normal=normal, along=along,
            aperture=aperture, bar=bar, length=length, thickness=thickness, lift=lift, staggered=staggered,
            radius=radius, model=model, clearance=clearance))
        return self._id(_lib.dem_wall_sieve_add(self._c, material, desc))

    def sieve_blinded(self, sieve, speed=0):
        """Returns how many grains, clusters included, blind a sieve. Such a grain is stuck in a hole: it touches the
        sieve on opposite sides, and the wedge between the two contacts is so narrow that friction holds the grain.
        Grains faster than speed (m/s, relative to the sieve; 0 means any) do not count. Reduced holes never blind. It
        is an error while there is no list of contacts (see World.contacts).
        """
        return self._number(_lib.dem_sieve_blinded_get(self._c, sieve, speed))

    def joint(self, *, kind=0, motor=0, a=None, b=None, wall=None, collide=0, point=None, axis=None, speed=0,
            torque=0):
        """Adds a joint. It is an error if the response is "springs", if neither of the two can move, or if a sphere is
        joined without World(orientations=...). A joint ends when one of its bodies or its wall is removed or leaves;
        its id is then invalid and is never used again. While both bodies are fixed, force, torque and power are 0;
        the joint acts again when one is released. Checkpoints contain joints.

        kind: required: how the two are joined; one of "none", "point", "revolute"
        motor: one of "none", "speed", "torque"
        a: required
        b: None means `wall`, or space
        wall: if b is None: moves with it; None means space, at rest
        collide: 1: the two bodies may touch each other
        point: m, where the two are joined
        axis: of a revolute joint, not 0; planar worlds: along z
        speed: rad/s, of a against b about axis, right-handed; at most 1e12 in size
        torque: N m, on a about axis; at most 1e12 in size. "speed": the largest torque, >= 0; 0 means no limit.
        Returns: Joint
        """
        desc = JointDesc._of_call('World.joint', dict(kind=kind, motor=motor, a=a, b=b, wall=wall, collide=collide,
            point=point, axis=axis, speed=speed, torque=torque))
        desc = self._bound(desc)
        return self._id(_lib.dem_joint_add(self._c, desc))

    def feed(self, *, material=None, class_count=0, radius=(), amount=(), limited=0, by_mass=0, rate=0,
            start=0, end=0, box=None, round=0, velocity=None, spread=0, seed=0, inside=None, inside_user=None,
            materials=None, shapes=None, sizes=None):
        """Adds a feed.

        material: required
        radius: m, required
        amount: > 0: relative amounts of the classes, or with `limited` grains (kg with by_mass)
        limited: 1: the feed ends after `amount`, drawn without replacement
        by_mass: 1: amount and rate are in kg and kg/s instead of grains
        rate: 1/s, grains due; 0 means all as room permits, and needs limited
        start: s, time of the world. A feed that is added later catches up with what was due since start.
        end: s, 0 or >= start; 0 means no end
        box: m, required: centres lie inside (Region: whole bodies)
        round: 1: only the vertical elliptic cylinder inscribed in the box
        velocity: m/s, of new grains
        spread: m/s, largest random change of each component of velocity
        seed: of random positions, sizes and velocities
        inside: restricts the box further, as in Region
        materials: A mixture: for each class, if not 0, its material; its shape, in random orientations and with the
            volume of a sphere of `radius`; and the distribution of its radius (copied).
        Returns: Feed
        """
        desc = FeedDesc._of_call('World.feed', dict(material=material, class_count=class_count, radius=radius,
            amount=amount, limited=limited, by_mass=by_mass, rate=rate, start=start, end=end, box=box, round=round,
            velocity=velocity, spread=spread, seed=seed, inside=inside, inside_user=inside_user, materials=materials,
            shapes=shapes, sizes=sizes))
        desc = self._bound(desc)
        return self._id(_lib.dem_feed_add(self._c, desc))

    def outlet(self, *, frame=None, box=None, beyond=0, wanted_min=0, wanted_max=0, class_count=0, radius=(),
            material=None, keep=0, residence_bin=0):
        """Adds an outlet. The wall that is its frame cannot be removed.

        frame: the region moves with this wall; None means at rest
        box: m, required, in that frame; lo < hi on every axis (planar worlds: z may be 0 to 0)
        beyond: m: only grains this far or farther from the frame's z axis
        wanted_min, wanted_max: m, radii meant to leave here; max 0 means no limit
        radius: m, ascending; a grain counts in the nearest class
        material: only grains of this material; None means all
        keep: 1: grains stay and are only counted; at most 16 such
        residence_bin: s, >= 0: width of a bin of residence times, which run from the insertion of a grain (grains
            that were there before: from World.outlet) until the outlet counts it; 0: not measured
        Returns: Outlet
        """
        desc = OutletDesc._of_call('World.outlet', dict(frame=frame, box=box, beyond=beyond, wanted_min=wanted_min,
            wanted_max=wanted_max, class_count=class_count, radius=radius, material=material, keep=keep,
            residence_bin=residence_bin))
        desc = self._bound(desc)
        return self._id(_lib.dem_outlet_add(self._c, desc))

    @property
    def step_advice(self):
        """Computes the time step that the scene allows as it is now, feeds included. It considers contacts to come.
        Contacts that are already compressed are examined when a run begins, and at least every 1000 steps later
        (every eight with World(law_rate=...)). If the step is too large for them, a given World(dt=...) makes
        World.step raise TimeStepError, and a chosen step is made smaller. An error if no grain can move, or with
        "impulses", where contacts have no duration.

        Returns: Advice
        """
        advice = Advice()
        self._ok(_lib.dem_step_advice_get(self._c, advice))
        self._with(advice)
        return advice

    def check(self):
        """Looks for likely mistakes before a scene runs, and returns them, the most severe first. Nothing moves; the
        neighbour list is rebuilt if it is out of date. It reports
        - grains that overlap each other or a wall by more than 1 % of their radius;
        - grains inside a closed mesh, profile or surface of revolution while others are outside, also grains that
            feeds will insert. A container that holds all grains is not reported. A mesh is closed if each edge has
            two triangles; walls that move together count as one mesh;
        - overlaps above 5 % of a radius to be expected from speed or weight, with the modulus that would keep them
            below 1 %;
        - values that suggest units other than m, kg/m3 and Pa;
        - positions so far from the origin that their last digits do not resolve overlaps;
        - scenes in which nothing moves, or grains fall for ever;
        - grains outside an outflow boundary, walls that no grain can reach, materials without use;
        - a time step that is too large, or 20 times smaller than necessary.

        Returns: a list of Finding
        """
        capacity = 64
        findings = _row(Finding, max(capacity, 1))()
        count = self._number(_lib.dem_world_check(self._c, ctypes.cast(findings, ctypes.POINTER(Finding)), capacity))
        return list(_fixed(findings)[:min(count, len(findings))])

    def check_print(self, out=None):
        """Prints the first 16 findings of World.check, one per line (nothing if there are none), and returns how many it
        found.
        """
        return self._print(_lib.dem_world_check_print, out, self._c)

    def step(self, steps=1):
        """Advances the world by `steps` time steps (>= 0), or to the first step that fails. The error message names that
        step; the steps before it are kept. The first step is not taken while the error message of a call that builds
        the scene is unread (World.error). Errors:
        ArgumentError: an unread message (above), or a scene that cannot run, such as a period that is too short, or
            rolling friction with a solver that ignores it
        TimeStepError: the step is too large for the contacts, or a body or wall would move by more than the smallest
            radius (a body under impulses: by more than this and more than half the range below which contacts are
            solved), a body that is not a sphere rotate by more than 1 rad, a cell strain by more than 0.01
        UnstableError: a position, velocity, force or number of a body is not finite, two bodies overlap by the
            smaller radius, a body and a wall by that of the body, or a motion or World(growth=...) returns impossible
            values
        FileError, FormatError: an output cannot be written; its CSV has other columns. The next call writes it, also
            one of 0 steps.
        StoppedError: an output stopped the run; World(unsolved_stops=1) and the sweeps of a step did not reach the
            tolerance; or an overlap is above World(overlap_stop=...). The step is complete.
        MemoryError: The bodies and the time may have moved already. The step counts (World.steps) when it is
            complete: the next call completes it as its first step, here or in a world that has read a checkpoint
            written meanwhile. The bits are those of a run without the interruption.
        """
        self._ok(self._run(_lib.dem_world_step, self._c, steps) if type(steps) is not int or steps != 1 or
            self._context.kept or self._context.runs else _lib.dem_world_step(self._c, steps))

    def run(self, seconds, progress=None):
        """Advances the world by `seconds` of simulated time (>= 0), to the nearest step. Consecutive calls add up:
        twenty of 0.05 s end within half a step of 1 s, because each counts from where the previous one should have
        ended (unless other steps were taken in between). progress: a function, or None. Errors as for World.step.

        progress: progress(world, done, seconds_left), see dem.ProgressFn
        """
        progress = self._callback(ProgressFn, _go_on if progress is None else progress, 'World.run: progress')
        self._ok(self._run(_lib.dem_world_run, self._c, seconds, progress, None))

    def run_to(self, time, progress=None):
        """Advances the world to a time of its clock, s, not before the present one. Otherwise as World.run. A program
        that has read a checkpoint can thus run to the same end.

        progress: progress(world, done, seconds_left), see dem.ProgressFn
        """
        progress = self._callback(ProgressFn, _go_on if progress is None else progress, 'World.run_to: progress')
        self._ok(self._run(_lib.dem_world_run_to, self._c, time, progress, None))

    def settle(self, seconds, speed=0, progress=None):
        """Advances the world until its bodies are at rest, for at most `seconds` of simulated time (> 0). At rest: at
        three checks in a row the root mean square speed, weighted by mass, is below `speed`, and no body is faster
        than 10 times that. Spins do not count, because nothing brakes a sphere that spins on a point. Checks are
        sqrt(R/g) apart, the time of a fall by half the mean radius R (without gravity: the time in which `speed`
        covers R/2, at most seconds/4). All feeds, also those that begin later, must have inserted all their grains
        first. speed: m/s, >= 0; 0: 0.01 sqrt(2 g R), which needs gravity. progress: a function, or None. Errors as
        for World.step; also ArgumentError for a feed with neither `limited` nor `end`, and StoppedError if the time
        is up: the message gives the speeds, the feed that is not done, or the time that three checks take; the state
        is intact.

        progress: progress(world, done, seconds_left), see dem.ProgressFn
        """
        progress = self._callback(ProgressFn, _go_on if progress is None else progress, 'World.settle: progress')
        self._ok(self._run(_lib.dem_world_settle, self._c, seconds, speed, progress, None))

    def gravity_set(self, gravity):
        """Sets gravity, m/s2 (components up to 1e15), from now on: for a mill seen from its shell, or a table that is
        tilted. Any number of calls between two steps is allowed. A planar world ignores z. World.desc returns it,
        checkpoints store it, and slabs take it over when they are created.
        """
        self._ok(_lib.dem_world_gravity_set(self._c, gravity))

    def cell_set(self, *, rate=None, shear=0, stress=None, rate_most=None):
        """Deforms the cell from now on, for tests of materials without walls. The centre of the domain stays in place.
        All positions, those of fixed bodies too, follow the strain affinely: the flow of the cell is rate (x -
        centre), plus shear (y - centre) along x. Velocities of bodies are relative to this flow, here and in
        user-defined functions, and their kinetic energy is that of these velocities. Contacts see the difference of
        the flow between both bodies, so no place of the cell differs from another [EVA08], and images across the y
        faces move with the shear [LEE72]. Along axes with a rate_most the rate is chosen before each step; its gain
        follows from the contacts. Further calls may change everything at any time; contact histories stay. Axes that
        move must be periodic; a shear needs x and y. The ledger counts the work of the cell as `cell`. Checkpoints
        store the cell. An error with "impulses", in slabs, and together with walls, joints, rails, feeds and outlets.
        Fields, fills and selections by region are an error while a cell is sheared. A step that would strain the cell
        by more than 0.01 fails with TimeStepError.

        rate: 1/s, strain rate of each axis; positive: the cell becomes longer
        shear: 1/s, shear rate: change of the velocity along x with y
        stress: Pa, pressure positive: target of axes that have a rate_most
        rate_most: 1/s, >= 0: largest strain rate by which the cell is led to `stress` along this axis, whose `rate`
            must be 0; 0: the axis follows `rate`
        """
        desc = CellDesc._of_call('World.cell_set', dict(rate=rate, shear=shear, stress=stress, rate_most=rate_most))
        self._ok(_lib.dem_cell_set(self._c, desc))

    @property
    def cell_state(self):
        """Returns the state of the cell.

        Returns: CellState
        """
        state = CellState()
        self._ok(_lib.dem_cell_state_get(self._c, state))
        self._with(state)
        return state

    def dt_set(self, dt):
        """Sets the time step, s (1e-20 to 1e15), from now on. 0: chosen from the scene, as with World(dt=...); an error
        with "impulses". Contact history stays. Checkpoints store the step. If it is too large, the next World.step
        raises TimeStepError.
        """
        self._ok(_lib.dem_world_dt_set(self._c, dt))

    @property
    def time(self):
        """Returns the simulated time, s."""
        found = _lib.dem_world_time_get(self._c)
        self._ok(0)
        return found

    @property
    def steps(self):
        """Returns the number of complete steps."""
        found = _lib.dem_world_steps_get(self._c)
        self._ok(0)
        return found

    @property
    def hash(self):
        """Returns a 64-bit digest of the state: time, positions, orientations, velocities, spins, walls, joints, feeds,
        outlets and contact history. Equal runs have equal digests.
        """
        found = _lib.dem_world_hash_get(self._c)
        self._ok(0)
        return found

    @property
    def counters(self):
        """Returns the counters.

        Returns: Counters
        """
        found = _lib.dem_counters_get(self._c)
        self._ok(0)
        return self._with(found)

    def overlap_max_reset(self):
        """Sets the counter overlap_max to 0, for instance after a scene has been built."""
        _lib.dem_overlap_max_reset(self._c)
        self._ok(0)

    @property
    def ledger(self):
        """Returns the ledger.

        Returns: Ledger
        """
        if not self.desc.ledger:
            raise _no_ledger()
        found = _lib.dem_ledger_get(self._c)
        self._ok(0)
        return self._with(found)

    @property
    def totals(self):
        """Computes the totals in one pass over the bodies.

        Returns: Totals
        """
        found = _lib.dem_totals_get(self._c)
        self._ok(0)
        return self._with(found)

    def observer_height(self):
        """Returns the height of the centre of mass above the origin, m: against gravity, or along z if there is none."""
        found = _lib.dem_observer_height(self._c, None)
        self._ok(0)
        return found

    def observer_kinetic(self):
        """Returns the kinetic energy of all bodies that can move, rotation included, J."""
        found = _lib.dem_observer_kinetic(self._c, None)
        self._ok(0)
        return found

    def observer_contacts(self):
        """Returns the mean number of contacts per body, walls included. A contact of two bodies counts for both."""
        found = _lib.dem_observer_contacts(self._c, None)
        self._ok(0)
        return found

    def observer_walls(self):
        """Returns the sum over all walls of the magnitude of the force on each, N."""
        found = _lib.dem_observer_walls(self._c, None)
        self._ok(0)
        return found

    def trials_run(self, *, duration=0, budget=0, tolerance=0, seeds=0, observable_count=0, observables=None,
            progress=None, user=None):
        """Runs the scene on copies with other choices, compares observables and wall time, and advises which choice to
        take. The world itself does not change. The trials are: the scene as it is; time steps twice, half and a
        quarter as long; grains 10 times softer and 4 times stiffer, with the same number of steps per contact;
        another normal law; another friction law. Trials that do not fit the scene are left out. The best trial is the
        cheapest whose `promise` is within the tolerance; a change must save a tenth of the time. If none is, the best
        is the reference. User-defined functions (laws, fields, motions, regions of feeds) are called for the copies,
        too, and may see the same simulated time again. Errors: no bodies; "impulses"; a budget too short for 64 steps
        per run; a scene that does not run. A trial that does not reach its end is not an error.

        duration: s, required, > 0: simulated by each run, at least 64 steps. Observables are averaged over its second
            half.
        budget: s, wall time of all trials, estimated from some steps of the scene; 0 means 60 s. If it is too short,
            the runs simulate less.
        tolerance: allowed deviation of an observable/its scale; 0 means 0.02
        seeds: 0 to 16, not 1: runs per trial, which start from positions that differ by at most 1e-6 of a radius; 0
            means 3
        progress: called with the original world after each trial; None means no call. A non-zero return value ends
            World.trials_run with StoppedError.
        Returns: Trials
        """
        trials = Trials()
        desc = TrialsDesc._of_call('World.trials_run', dict(duration=duration, budget=budget, tolerance=tolerance,
            seeds=seeds, observable_count=observable_count, observables=observables, progress=progress, user=user))
        desc = self._bound(desc)
        if progress is None:
            desc._progress = self._callback(ProgressFn, _go_on, None)
        self._ok(self._run(_lib.dem_trials_run, self._c, desc, trials))
        return trials

    @property
    def contacts(self):
        """Returns the contacts, those with walls included. The contact history does not change. A contact of two
        polyhedra, or of one with a wall, is written as up to four (World.shape_polyhedron). Contacts of two spheres
        are those of the present state; all others, and with impulses all, are as the last computation of forces has
        left them. With impulses these forces, gravity and force fields together give the change of the velocities in
        the coming step. After bodies, walls or materials have changed, call World.contacts_each first: it computes
        them. It is an error if they are not known: before the first step, and after bodies or walls have changed.

        Returns: Structs of ContactInfo
        """
        capacity = self._number(_lib.dem_contacts_get(self._c, None, 0))
        out = _row(ContactInfo, max(capacity, 1))()
        count = self._number(_lib.dem_contacts_get(self._c, ctypes.cast(out, ctypes.POINTER(ContactInfo)), capacity))
        array = _row(out._type_, count).from_buffer(out)
        return Structs(array)

    def contacts_each(self, fn=None):
        """Calls `fn` for every contact, those with walls included, and returns their number. With a law that has a range
        these are all pairs within the range. Computes forces first if the scene has changed.

        fn: fn(contact, memory), see dem.ContactFn
        """
        fn = self._callback(ContactFn, _seen if fn is None else fn, 'World.contacts_each: fn')
        return self._number(_lib.dem_contacts_each(self._c, fn, None))

    def bonds_make(self, gap, make):
        """Calls `make` for every pair of bodies (no walls) with a gap below `gap`, and returns their number, so that
        `make` can write a bond into the contact history of a user-defined law. gap: m, >= 0, at most the range of the
        law for the two smallest grains: law_range + law_range_radii times the sum of their radii. Errors as for
        World.contacts_each.

        make: make(contact, memory), see dem.ContactFn
        """
        make = self._callback(ContactFn, make, 'World.bonds_make: make')
        return self._number(_lib.dem_bonds_make(self._c, gap, make, None))

    @property
    def candidates(self):
        """Returns the candidate pairs of the neighbour list (count x 2: Body.slot of a and b). It is an error if bodies
        or walls have changed since the last step.
        """
        capacity = self._number(_lib.dem_candidates_get(self._c, None, 0))
        out = _row(_row(ctypes.c_uint32, 2), max(capacity, 1))()
        count = self._number(_lib.dem_candidates_get(self._c, ctypes.cast(out, ctypes.POINTER(ctypes.c_uint32)),
            capacity))
        array = _row(out._type_, count).from_buffer(out)
        return array

    def candidates_rebuild(self):
        """Rebuilds the neighbour list, not the contacts, for tests and analysis. A run does so too."""
        self._ok(_lib.dem_candidates_rebuild(self._c))

    def events_record(self, *, function=None, user=None, begins=0):
        """Starts to record contacts; needs World(ledger=...). If they are recorded already, replaces the function and
        keeps the records. Forces and motions have the same bits as without a recording. Checkpoints contain the
        records, but not the function: call this again after reading one in a new program. Slabs continue the
        recording of the world from which they are created, if one process holds them all; Slabs.collect returns it. A
        step that has no memory for the records completes, stops the recording and fails with MemoryError.

        function: called after each step for the contacts that have ended in it; None means no call. The contacts are
            in the order of their ids, for any number of threads and slabs.
        begins: 1: also called for contacts that have begun, before those
        """
        desc = EventsDesc._of_call('World.events_record', dict(function=function, user=user, begins=begins))
        desc = self._bound(desc)
        self._ok(_lib.dem_events_record(self._c, desc))

    def events_stop(self):
        """Ends the recording and discards its records."""
        self._ok(_lib.dem_events_stop(self._c))

    def events_open_each(self, fn=None):
        """Calls `fn` for every contact that exists, in the order of ids, and returns their number. It is an error if
        contacts are not recorded.

        fn: fn(event), see dem.EventFn
        """
        fn = self._callback(EventFn, fn, 'World.events_open_each: fn')
        return self._number(_lib.dem_events_open_each(self._c, fn, None))

    def impacts(self, a=None, b=None):
        """Computes the statistics of contacts between two materials, walls included; material None means any. An error
        if contacts are not recorded.

        Returns: Impacts
        """
        impacts = Impacts()
        self._ok(_lib.dem_impacts_get(self._c, a, b, impacts))
        self._with(impacts)
        return impacts

    def impacts_csv_write(self, path):
        """Writes the spectra of all pairs of materials that have touched to a CSV file. A line per bin that is not
        empty: material_a, material_b, from, to (J), impacts, losses (both 1/s), power (W).
        """
        self._ok(_lib.dem_impacts_csv_write(self._c, _text_of(path, 'World.impacts_csv_write: path')))

    @property
    def stress(self):
        """Computes stress and fabric of the present state in one pass over bodies and contacts. The domain must have an
        extent along all axes (planar: along x and y; its depth is World(thickness=...)). An error if bodies or walls
        have changed since the last step; then call World.contacts_each first (see World.contacts).

        Returns: Stress
        """
        stress = Stress()
        self._ok(_lib.dem_stress_get(self._c, stress))
        self._with(stress)
        return stress

    def field(self, *, box=None, cells=(), start=0, end=0, interval=0, material=None, radius_min=0,
            radius_max=0, stress=0, width=0, group=None, variance=0, bodies=0):
        """Adds a field, and returns its id. Steps sample it from then on.

        box: m, required: what the cells divide. In planar worlds cells are World(thickness=...) deep, whatever the
            extent of the box along z, which must contain 0.
        cells: required, >= 1: along each axis, at most 2^28 in all
        start, end: s, window of time; end 0 means no end
        interval: s, from start on; 0 means every 100 steps of the present dt
        material: only grains of this material; None means all grains
        radius_min, radius_max: m, only of these (bounding) radii; max 0 means any
        stress: 1: also flux, stress and contacts; visits every contact
        width: m, of coarse graining; 0 means none. Each grain is then spread by Lucy's function of reach c = 2 width
            [GOL10], 105/(16 pi c^3) (1 + 3 r/c) (1 - r/c)^3 (planar: 5/(pi c^2) in place of the first factor),
            evaluated at the centres of cells. Keep cells no longer than width.
        group: only members of this group; None means all grains
        variance: 1: also variances of cells over the samples; not in slabs
        bodies: 1: also averages each grain (BodyMeans); one field may
        Returns: Field
        """
        desc = FieldDesc._of_call('World.field', dict(box=box, cells=cells, start=start, end=end, interval=interval,
            material=material, radius_min=radius_min, radius_max=radius_max, stress=stress, width=width, group=group,
            variance=variance, bodies=bodies))
        desc = self._bound(desc)
        return self._id(_lib.dem_field_add(self._c, desc))

    def mixing(self, *, box=None, cells=(), material=None, radius_min=0, radius_max=0, centre=None,
            axis=None):
        """Computes the mixing of two components from the present places of all grains.

        box: m, required: what the cells divide
        cells: required, >= 1: along each axis; 10 to 30 grains per cell suit
        material: the component: a material (id 0: any), and (bounding) radii, m (max 0: any); not both open
        centre: m, a point on an axis
        axis: its direction, of any length, 0: no axis
        Returns: Mixing
        """
        mixing = Mixing()
        desc = MixingDesc._of_call('World.mixing', dict(box=box, cells=cells, material=material,
            radius_min=radius_min, radius_max=radius_max, centre=centre, axis=axis))
        desc = self._bound(desc)
        self._ok(_lib.dem_mixing_get(self._c, desc, mixing))
        self._with(mixing)
        return mixing

    def repose_heap(self, box=None):
        """Measures the angle of repose of a heap. It considers grains in `box` (m; both corners 0: all) that can move
        and are connected by gaps below half their mean radius, and takes the heaviest of several heaps. Grains that
        ran away, fell off a table or fly therefore do not count. The surface consists of the highest grains by
        distance from the vertical through the centre of mass. The line is fitted from 20 to 80 % of its height,
        without the rounded top and the toe; in a planar world to the mean of both flanks. An error without gravity or
        with fewer than four points.

        Returns: Repose
        """
        repose = Repose()
        self._ok(_lib.dem_repose_heap_get(self._c, box, repose))
        self._with(repose)
        return repose

    def repose_drum(self, box, axis):
        """Measures the dynamic angle of repose in a drum that rotates about `axis` (right-handed, of any length,
        horizontal): positive if the surface rises in the direction in which the bottom of the drum moves. The line is
        fitted to the middle half of the surface. It suits charges that roll or cascade; grains in flight belong to no
        surface. `box` and errors as for World.repose_heap.

        Returns: Repose
        """
        repose = Repose()
        self._ok(_lib.dem_repose_drum_get(self._c, box, axis, repose))
        self._with(repose)
        return repose

    def mesh_read(self, path):
        """Reads the triangles of a file and counts its defects. The contents identify the format: STL (text or binary),
        OBJ, or the text format of [MIL] (counts, vertices, corners counted from 1). OBJ faces of more than three
        corners become triangles that cover them once and keep their winding; a face that is not convex may have
        10,000 corners. Error messages name file, line and reason.

        Returns: Mesh, MeshHealth
        """
        mesh = Mesh()
        health = MeshHealth()
        self._ok(_lib.dem_mesh_read(self._c, _text_of(path, 'World.mesh_read: path'), mesh, health))
        mesh = self._taken(mesh, _lib.dem_mesh_free)
        self._with(health)
        return mesh, health

    def mesh_parse(self, name, data):
        """Reads triangles from memory (`data`), as World.mesh_read does. name: for error messages.

        Returns: Mesh, MeshHealth
        """
        data = _data_of(data, 'World.mesh_parse: data')
        mesh = Mesh()
        health = MeshHealth()
        self._ok(_lib.dem_mesh_parse(self._c, _text_of(name, 'World.mesh_parse: name'), data, len(data), mesh,
            health))
        mesh = self._taken(mesh, _lib.dem_mesh_free)
        self._with(health)
        return mesh, health

    def mesh_part_read(self, path, part):
        """Reads one named part of a file, such as the shell, the ends or the lifters of a drum. In an STL text file this
        is the solid of that name (the whole rest of its line). In an OBJ file these are the faces whose object (`o
        NAME`) or one of whose groups (`g NAME NAME`) has that name; a `g` line replaces the groups before it and
        leaves the object. If the file has no such part, the error message lists its parts.

        Returns: Mesh, MeshHealth
        """
        mesh = Mesh()
        health = MeshHealth()
        self._ok(_lib.dem_mesh_part_read(self._c, _text_of(path, 'World.mesh_part_read: path'), _text_of(part,
            'World.mesh_part_read: part'), mesh, health))
        mesh = self._taken(mesh, _lib.dem_mesh_free)
        self._with(health)
        return mesh, health

    def mesh_place(self, mesh, scale, rotation, to):
        """Scales a mesh about its origin (scale > 0; 1e-3: from mm to m), rotates it about the origin, and moves it by
        `to` (m, components up to 1e15). A rotation of zeros is none; any other length is normalised. Call it before
        the mesh becomes a wall or a shape.
        """
        self._ok(_lib.dem_mesh_place(self._c, _struct_of(Mesh, mesh, 'World.mesh_place: mesh'), scale, rotation, to))

    def mesh_spheres(self, mesh, count):
        """Approximates a closed mesh by `count` spheres (1 to 1000), for a cluster: returns positions (count x 3) and
        radii, m, in the frame of the mesh. On a grid with 40 points along the longest side, each sphere is placed
        where it leaves the fewest points wrong; then all are placed again, one at a time, while that helps. A cluster
        of few spheres has the mass and moments of the body if it gets volume, centre and inertia of `fit` ("given").
        Inconsistent winding, a mesh that is inside out, and duplicate triangles do no harm. A shell inside another
        that faces the other way is a cavity. Errors: an open mesh, edges whose triangles do not pair, a surface with
        one side only, shells that cross or that face the same way as the shell around them, a mesh too thin for any
        sphere.

        Returns: Row, Row, SpheresFit
        """
        mesh = self._bound(_struct_of(Mesh, mesh, 'World.mesh_spheres: mesh'))
        positions = _row(_row(Real, 3), _size_of(count, 'World.mesh_spheres: count'))()
        radii = _row(Real, _size_of(count, 'World.mesh_spheres: count'))()
        fit = SpheresFit()
        self._ok(_lib.dem_mesh_spheres(self._c, mesh, count, ctypes.cast(positions, ctypes.POINTER(Real)),
            ctypes.cast(radii, ctypes.POINTER(Real)), fit))
        self._with(fit)
        return positions, radii, fit

    def wall_parts(self, path, scale, parts):
        """Adds a machine from CAD: `count` (>= 1) named parts of a file (STL text, OBJ), each as a wall with its own
        material and motion. scale: m per unit of length of the file, > 0; 0: 1. If one part fails, no wall is added.

        Returns: a list of Wall
        """
        parts = _array_of(_parts_of(parts, self, 'World.wall_parts: parts'), WallPart, 'World.wall_parts: parts', 1)
        count = len(parts)
        walls = _row(Wall, max(count, 1))()
        self._ok(_lib.dem_wall_parts_add(self._c, _text_of(path, 'World.wall_parts: path'), scale, count, parts,
            ctypes.cast(walls, ctypes.POINTER(Wall))))
        walls = [item.of(self) for item in walls]
        return walls

    def profile_read(self, path):
        """Reads the segments of a profile in the text format of [MIL] in 2-D: the counts of vertices and segments, x y
        per vertex, two corners counted from 1 per segment.

        Returns: Profile
        """
        profile = Profile()
        self._ok(_lib.dem_profile_read(self._c, _text_of(path, 'World.profile_read: path'), profile))
        profile = self._taken(profile, _lib.dem_profile_free)
        return profile

    def profile_parse(self, name, data):
        """Reads the segments of a profile from memory (`data`). name: for error messages.

        Returns: Profile
        """
        data = _data_of(data, 'World.profile_parse: data')
        profile = Profile()
        self._ok(_lib.dem_profile_parse(self._c, _text_of(name, 'World.profile_parse: name'), data, len(data),
            profile))
        profile = self._taken(profile, _lib.dem_profile_free)
        return profile

    def grains_read(self, path):
        """Reads grains from a file. The contents identify the format; lengths are in m:
        - text or CSV, one line per grain. Columns are separated by semicolons, tabs, commas or blanks, as in the
            first line. A decimal comma is allowed between semicolons or tabs. Cells may be quoted; # begins a
            comment. The first line, or a comment before it, names the columns; without names they are x y z r, or x y
            z r vx vy vz. An empty cell in a column that is used is an error.
        - extended XYZ with Properties (OVITO, ASE, World.xyz_write), and dumps of LAMMPS and LIGGGHTS: the first
            frame. Pass the lines of another frame to World.grains_parse.
        - legacy VTK, VTP and VTU (ParaView, LIGGGHTS, World.vtp_write) as ASCII, base64 or raw bytes; a compressed
            file is an error.
        Names, in upper or lower case:
        position: x y z, or position, pos, points
        size: r or radius, d or diameter
        velocity: vx vy vz, or v, vel, velo, velocity
        angular velocity: wx wy wz, or omega, spin, angular_velocity
        material: material; otherwise type, if it is a number
        A component may follow a name, as in velocity:0, omegax, Position.X, and then a unit: (m), (mm), (cm), (um),
        (mm/s), (rad/s). `ignored` lists other columns, and the second of two that mean the same. Each sphere of a
        file of clusters becomes one grain. Error messages name file, line and reason.

        Returns: Grains
        """
        grains = Grains()
        self._ok(_lib.dem_grains_read(self._c, _text_of(path, 'World.grains_read: path'), grains))
        grains = self._taken(grains, _lib.dem_grains_free)
        return grains

    def grains_parse(self, name, data):
        """Reads grains from memory (`data`), as World.grains_read does. name: for error messages.

        Returns: Grains
        """
        data = _data_of(data, 'World.grains_parse: data')
        grains = Grains()
        self._ok(_lib.dem_grains_parse(self._c, _text_of(name, 'World.grains_parse: name'), data, len(data), grains))
        grains = self._taken(grains, _lib.dem_grains_free)
        return grains

    def grains(self, material, grains):
        """Adds all grains as spheres of one material or, if its id is 0, of the materials whose numbers the file gives.
        If one grain has a bad value, none is added.
        """
        grains = self._bound(_struct_of(Grains, grains, 'World.grains: grains'))
        self._ok(_lib.dem_grains_add(self._c, material, grains), grains)

    def vtp_write(self, path):
        """Writes the bodies for ParaView (VTP): points with radius, velocity, spin, id, material and body_reals, with
        World(groups=...) also groups (bit id - 1: in that group). A cluster or union is one point per sphere or
        piece, all with its id. If bodies have orientations, also the orientation of the piece (quaternion w x y z)
        and its semi_axes (m). To draw them in ParaView: Glyph, a sphere of radius 1, scaled by semi_axes, rotated by
        orientation (quaternion).
        """
        self._ok(_lib.dem_vtp_write(self._c, _text_of(path, 'World.vtp_write: path')))

    def vtk_write(self, path):
        """Writes the same as a legacy VTK file, binary."""
        self._ok(_lib.dem_vtk_write(self._c, _text_of(path, 'World.vtk_write: path')))

    def xyz_write(self, path):
        """Writes the bodies for OVITO and ASE (extended XYZ): a chemical element that numbers the material (H: 1, He:
        2), position, radius, velocity, body_reals and id. If bodies have orientations, also the orientation (x y z w)
        and semi-axes. The domain becomes the lattice.
        """
        self._ok(_lib.dem_xyz_write(self._c, _text_of(path, 'World.xyz_write: path')))

    def contacts_vtp_write(self, path):
        """Writes the contacts for ParaView (VTP), to show bonds, bridges and force chains: lines from centre to centre
        (with a wall: to the contact point), with force (N, on a), overlap (m), wall (id, 0: none) and the contact
        history under its names. Computes forces first if the scene has changed.
        """
        self._ok(_lib.dem_contacts_vtp_write(self._c, _text_of(path, 'World.contacts_vtp_write: path')))

    def walls_vtp_write(self, path, z0, z1):
        """Writes the triangles of all meshes, profiles and surfaces of revolution in their present pose (VTP), with the
        id of the wall. Profiles are extruded from z0 to z1 (m, z0 < z1). While contacts are recorded
        (World.events_record), the column `sliding` has the work of sliding on the facet or segment of each triangle,
        J, as returned by Wall.wear_facets. It is 0 on surfaces of revolution.
        """
        self._ok(_lib.dem_walls_vtp_write(self._c, _text_of(path, 'World.walls_vtp_write: path'), z0, z1))

    def surfaces_vtp_write(self, path):
        """Writes the surfaces of all bodies as polygons (VTP), with velocity (of each corner), id, material and
        body_reals. Polyhedra are drawn by their faces, round bodies by facets.
        """
        self._ok(_lib.dem_surfaces_vtp_write(self._c, _text_of(path, 'World.surfaces_vtp_write: path')))

    def bodies_csv_write(self, path):
        """Writes the bodies: id, number of the material, (bounding) radius, position, velocity, spin and body_reals. If
        a field averages bodies (FieldDesc.bodies), also the samples, and mean and variance of velocity, spin and
        force. World.grains_read reads such a table.
        """
        self._ok(_lib.dem_bodies_csv_write(self._c, _text_of(path, 'World.bodies_csv_write: path')))

    def contacts_csv_write(self, path):
        """Writes the contacts: ids of a and b (-1: a wall), wall (0: none), point (m), normal (from a to b), overlap (m)
        and force (N, on a). Computes forces first if the scene has changed.
        """
        self._ok(_lib.dem_contacts_csv_write(self._c, _text_of(path, 'World.contacts_csv_write: path')))

    def replay(self, path, *, title=None, number=None, number_fn=None, user=None, resolution=0, interval=0,
            contacts=0):
        """Opens a replay of the world. Close the replay before its world is destroyed.

        title: copied; None means the name of the file
        number: Name of the numbers by which grains can be coloured: one in World(body_reals=...), a group in
            World(groups=...) (1: member, 0: not), or one for the values of number_fn. None means the first name, or
            "number". Copied, at most 63 characters.
        number_fn: returns the number of a body, for every frame; None means one of World(body_reals=...)
        resolution: m, >= 0, of positions; 0 means 1/32 of the smallest radius in the first frame
        interval: s, >= 0: a run writes frames automatically, the first when it begins and then at the steps nearest
            to multiples of the interval. A frame that cannot be written ends the replay, not the run: Replay.close
            returns the error. 0 means frames only from Replay.frame_write.
        contacts: >= 0: n records the contact forces in every n-th frame. The viewer draws them as lines between
            centres, or from a centre to the contact point with a wall, wider and redder for larger forces. A frame
            has at most the 50,000 largest, and none below 1 % of its largest. 0 means none.
        Returns: Replay
        """
        desc = ReplayDesc._of_call('World.replay', dict(title=title, number=number, number_fn=number_fn, user=user,
            resolution=resolution, interval=interval, contacts=contacts))
        desc = self._bound(desc)
        return Replay(self._pointer(_lib.dem_replay_open(self._c, _text_of(path, 'World.replay: path'), desc)), self,
            path)

    def checkpoint_write(self, path):
        """Writes a checkpoint: the whole state, with bodies, walls, contact history, neighbour list, ledger, fields,
        counters, and what each scheduled output has written. An error if a body is not at a finite position and
        velocity; then an existing file stays.
        """
        self._ok(_lib.dem_checkpoint_write(self._c, _text_of(path, 'World.checkpoint_write: path')))

    def checkpoint_read(self, path):
        """Reads a checkpoint and replaces the state of the world, which then continues bit for bit. The world must have
        been built like the one that wrote it, with the same desc, materials, pairs, shapes, walls, fields, feeds and
        outlets. Functions and user pointers are not stored. Number of threads, allocator, allow_large_dt,
        unsolved_stops, overlap_stop, law_rows and user pointers may differ. Errors: a file that is cut short,
        damaged, or of another version, precision, DEM_DOMAIN_BODIES or memory layout; a file of another scene, for
        which the message names the first field that differs, with both values.
        """
        self._ok(_lib.dem_checkpoint_read(self._c, _text_of(path, 'World.checkpoint_read: path')))

    def checkpoint_read_changed(self, path, allowed):
        """The same for a world that differs from the one that wrote the file. allowed: words, each the name of a field
        of WorldDesc, such as "dt ledger orientations tangent_law", or "materials" (all but density, and the pairs
        that are mixtures of them) or "pairs" (also those of World.pair_set); "" allows nothing. Fields named there
        keep the values of this world. Everything else must agree; domain, boundary, planar, thickness, response,
        body_reals, law_memory_names, groups, shapes, walls, fields, feeds and outlets always. Contact histories are
        converted where a law is the same, and begin at 0 if a law is user-defined and `law`, `law_memory` or the like
        differs. If the file has no ledger, the ledger begins with the present kinetic energy as `inserted` and the
        present elastic energy as `growth`. Otherwise `growth` receives the energy that springs hold more than in the
        file.
        """
        self._ok(_lib.dem_checkpoint_read_changed(self._c, _text_of(path, 'World.checkpoint_read_changed: path'),
            _text_of(allowed, 'World.checkpoint_read_changed: allowed')))

    @property
    def checkpoint_changes(self):
        """Returns what differed in the last checkpoint that World.checkpoint_read_changed has read, such as "dt: 1e-05
        there, 2e-05 here", or "".
        """
        return (_lib.dem_checkpoint_changes_get(self._c) or b'').decode()

    def output(self, *, kind=0, path=None, interval=0, start=0, end=0, wall=None, columns=None, values=None,
            function=None, user=None, mixing=None, field=None, z0=0, z1=0, outlet=None):
        """Adds an output that a run writes automatically, at the steps nearest to start, start + interval and so on, in
        the order in which outputs were added. The first line of a CSV file replaces an older file of that name; a
        file with other columns is an error of the run. If a file cannot be written, the run stops with the state
        intact, and the next run tries that output again. Slabs have no outputs. After a restart: a checkpoint stores
        what each output has written. A world that reads it continues from there, with nothing missing and nothing
        twice, and removes later lines of a CSV file before it appends the next. Outputs are matched by kind and path,
        so add them before reading the checkpoint. Other outputs may be added, and times may differ. A function
        ("call") may add outputs, and write and read checkpoints; a checkpoint that it writes counts the present call
        as done.

        kind: one of "call", "vtp", "xyz", "contacts", "checkpoint", "csv", "surfaces", "walls", "bodies_csv",
            "contacts_csv", "field_csv"
        path: Name of the file, copied. In "grains_####.vtp" the number of the output replaces ####; it is 0 at
            `start`. Without # the file is replaced each time. The path of a CSV file has no #. "call": or None.
        interval: s, required, 1e-12 to 1e15
        start, end: s, times of the first and the last; end 0 means no last
        wall: kind "csv": what a line contains. One of five: the loads of this wall, as Wall.loads_csv_write; the
            counts of an outlet; the mixing of two components, if mixing.cells are set; the values that `values`
            writes, with `columns` as their names (1 to 32 words as in body_reals, copied); or, if none of these is
            set, steps, bodies, contacts, kinetic and rotational energy (J) and overlap_max
        function: kind "call": may change the world, but not step it. A return value other than 0 stops the run
            (StoppedError).
        mixing: kind "csv": see above
        field: kind "field_csv": required
        z0, z1: m, kind "walls": profiles are extruded from z0 to z1 (z0 <= z1). If they are equal, as with
            World.output_every: over World(thickness=...) (planar), over World(domain=...) along z if it has an
            extent, or else from the lowest to the highest body
        outlet: kind "csv": grains that the outlet has counted (total, sorted, gangue, back, held) and their mass, kg,
            as in OutletState
        Returns: Output
        """
        desc = OutputDesc._of_call('World.output', dict(kind=kind, path=path, interval=interval, start=start, end=end,
            wall=wall, columns=columns, values=values, function=function, user=user, mixing=mixing, field=field,
            z0=z0, z1=z1, outlet=outlet))
        desc = self._bound(desc)
        return self._id(_lib.dem_output_add(self._c, desc))

    def output_every(self, kind, path, interval):
        """Adds an output by kind, path and interval (s) alone: World.output_every(world, "vtp", "grains_####.vtp",
        0.01).

        Returns: Output
        """
        return self._id(_lib.dem_output_every_add(self._c, _enum_of(kind, OutputKind, 'World.output_every: kind'),
            _text_of(path, 'World.output_every: path'), interval))

    def slabs(self, *, axis=0, count=0, first=0, local=0, transport=None, balance=0, balance_interval=0):
        """Creates slabs from a world: copies its grains to them, with everything a step needs. The world stays as it is,
        and may be destroyed. Every process builds the same world and passes its own `first` and `local`. Feeds and
        outlets continue in the slabs. Errors, which world.error has: impulses, bodies on rails, a deformed cell, a
        field with variance; a recording of contacts if several processes hold the slabs; processes that have built
        different scenes.

        axis: 0, 1, 2: borders are planes x, y, z = const
        count: required, 1 to 1024: number of slabs in all processes; only runs with the same number have the same
            bits
        first, local: this process holds the slabs first to first + local - 1; local 0 means all
        transport: required if another process holds slabs
        balance: borders move if the work of the busiest slab exceeds this many times the mean, >= 1; 0 means 1.1.
            Below 0 borders do not move.
        balance_interval: rebuilds between two checks of the balance; 0 means 8
        Returns: Slabs
        """
        desc = SlabsDesc._of_call('World.slabs', dict(axis=axis, count=count, first=first, local=local,
            transport=transport, balance=balance, balance_interval=balance_interval))
        return Slabs(self._pointer(_lib.dem_slabs_create(self._c, desc)), self)

    def effects(self, budget=0):
        """Returns for every effect whether it is off, idle or active. It finds a material with rolling friction on which
        nothing has rolled, or a wall that nothing has touched. It can miss contacts of spheres that begin and end
        between two neighbour lists. If `budget` (s of wall time, >= 0) is not 0, it also measures what each effect
        costs: two copies of the world, one without the effect, take steps in turn. User-defined laws (by pointer) and
        fields are called twice instead of being left out, and friction is left out together with rolling friction.
        Shares need not add up to 1; on a busy machine they are noise. User-defined functions are called for the
        copies, too. The world does not change. It is an error if the scene would not run.

        Returns: a list of Effect
        """
        effects = _row(Effect, max(EFFECTS, 1))()
        count = self._number(_lib.dem_effects_get(self._c, budget, ctypes.cast(effects, ctypes.POINTER(Effect))))
        return list(_fixed(effects)[:min(count, len(effects))])

    def effects_print(self, budget=0, out=None):
        """Prints the effects as lines of text. A share outside -0.1 to 1, or with an error above 0.1, is printed as "too
        noisy".
        """
        return self._print(_lib.dem_effects_print, out, self._c, budget)

    def report(self, out=None):
        """Prints the report: bodies, time step and what limits it, contact detection, laws and effects, what the scene
        contains but has not happened, the largest overlap, pairs of materials, loads of walls, joints, feeds,
        outlets, and the ledger. It calls a user-defined force field and World(growth=...) once per body.
        """
        return self._print(_lib.dem_world_report, out, self._c)


class Replay(ReplayBase):
    """A replay: world.replay(path) opens it, close() or the end of a `with` block completes the file. Jupyter shows a
    replay that is closed."""

    def frame_write(self):
        """Writes the present state as a frame. 30 to 300 frames make a good replay."""
        self._ok(_lib.dem_replay_frame_write(self._c))

    def value_set(self, name, value):
        """Sets a value of the next frame, which the replay plots against time. name: 1 to 63 characters, at most 16
        different names; it ends with the unit in brackets, and values with the same unit share a scale. A value that
        is not finite leaves a gap.
        """
        self._ok(_lib.dem_replay_value_set(self._c, _text_of(name, 'Replay.value_set: name'), value))


class Slabs(SlabsBase):
    """The slabs that one process holds."""

    def step(self, steps):
        """Advances all slabs by `steps` time steps (>= 0). Errors as for World.step; StoppedError also if the transport
        has failed.
        """
        self._ok(self._run(_lib.dem_slabs_step, self._c, steps) if type(steps) is not int or steps != 1 or
            self._context.kept or self._context.runs else _lib.dem_slabs_step(self._c, steps))

    def collect(self, world):
        """Copies the state of all slabs into a world of the same scene, in every process: grains, contact history,
        walls, loads, fields, feeds, outlets, ledger, time. The world can then be measured, written, stepped, or
        divided into slabs again, without effect on these slabs. It has no neighbour list until
        World.candidates_rebuild; after that it continues as the slabs would.
        """
        self._ok(_lib.dem_slabs_collect(self._c, _handle_of(world, World, 'Slabs.collect: world')))

    def loads_reset(self):
        """Sets the time integrals of wall loads and the largest overlap to 0, in this process's slabs."""
        _lib.dem_slabs_loads_reset(self._c)
        self._ok(0)

    @property
    def error(self):
        """Returns the error message of the last failed call on these slabs, or ""."""
        return (_lib.dem_slabs_error_get(self._c) or b'').decode()

    def slab(self, index):
        """Describes one slab of this process; index: first to first + local - 1.

        Returns: Slab
        """
        slab = Slab()
        self._ok(_lib.dem_slab_get(self._c, index, slab))
        self._with(slab)
        return slab

    @property
    def counters(self):
        """Returns the counters of slabs.

        Returns: SlabsCounters
        """
        found = _lib.dem_slabs_counters_get(self._c)
        self._ok(0)
        return self._with(found)


def quat_about(axis, angle):
    """The right-handed rotation by `angle` (rad) about `axis` (any length except 0).

    Returns: Quat
    """
    return _lib.dem_quat_about(axis, angle)


def quat_multiply(a, b):
    """The product a b: the rotation b followed by the rotation a.

    Returns: Quat
    """
    return _lib.dempy_quat_multiply(a, b)


def quat_rotate(q, v):
    """Rotates v from the frame of a body into the world frame. q must have unit length.

    Returns: Vec3
    """
    return _lib.dempy_quat_rotate(q, v)


def quat_unrotate(q, v):
    """Rotates v from the world frame into the frame of a body. q must have unit length.

    Returns: Vec3
    """
    return _lib.dempy_quat_unrotate(q, v)


def memory_rotate(c, v):
    """Rotates a tangent vector of the contact history with the contact plane over the last step: with the normal, and
    with the mean spin of the two bodies about it. The result lies in the tangent plane and has the length of v. Laws
    with a tangential spring call it first. Accuracy: the rotation of the normal is exact to sixth order in its angle.
    The rotation t about the normal is limited to 1 rad per step; it shortens v by a fraction of t^4/64 and never
    lengthens it: (1 - u/2)^2 + u (1 - 9 u/64)^2 <= 1 with u = t^2 <= 1.

    Returns: Vec3
    """
    return _lib.dempy_memory_rotate(c, v)


def law_load(c, f, hold):
    """Computes the load for friction and removes a dashpot's attraction. A normal law calls it after it has set
    f.elastic and f.normal. Without tension (CLIPPED, COMPENSATED) f.normal is raised to 0, or to the elastic force if
    that attracts. The load is that of c.friction_load, at least 0; without tension it is always the whole normal
    force. hold: N, >= 0, adhesion that adds to the load (not with "magnitude"); 0: none.
    """
    return _lib.dempy_law_load(c, f, hold)


def law_hertz(c, memory, f):
    """The normal force of elastic spheres with a dashpot:
    F = kn d^(3/2) + cn d^(1/4) v [HER82, TSU92], d: overlap, v: closing speed.
    The tangential coefficients are kt d^(1/2) [N/m] and ct d^(1/4) [N s/m]. No contact history.
    """
    return _lib.dempy_law_hertz(c, memory, f)


def law_linear(c, memory, f):
    """The normal force of a linear spring and dashpot: F = kn d + cn v. No contact history."""
    return _lib.dempy_law_linear(c, memory, f)


def law_hysteretic(c, memory, f):
    """The normal force of a plastic, possibly sticky contact [ALK07] eq 2.41 to 2.49:
    F = kun d - (kun - kn) D + cn v, D: depth of the plastic deformation, m
    loading: d = D, so that F = kn d
    unloading and reloading: slope kun; F = 0 at d0 = (1 - kn/kun) D [eq 2.44]
    adhesion: F = -kad d. D shrinks with d here, so that reloading (slope kun) returns to kn d at the D that belongs
        to this point
    After each step D is the larger of D and d, but at most d (kun + kad)/(kun - kn). Unloading and adhesion join at
    d_ad = (kun - kn) D/(kun + kad) = (1 - e^2) kn D/(kn + kad e^2), e^2 = kn/kun. Differences from [ALK07]: kad is a
    magnitude here. It defines kad as a negative slope; with that its eq 2.48 and 2.49 have the wrong sign, and its
    text calls d_ad both a deformation and a force. The load of friction is F + kad d, which is 0 on the adhesion
    line. [ALK07] takes |F|, which is 0 where F is 0 and large where the two are pulled apart. Energy: the contact
    stores F^2/(2 kun). A change of D dissipates F (1 - kn/kun) dD, summed exactly along both lines. Motion along the
    slope kun loses nothing, so that a grain at rest oscillates there unless the pair has normal_damping (cn). kun
    must be > 0. Without "hysteretic" a user-defined law sets it in a copy of *c. Contact history: 1 real, D [m].
    """
    return _lib.dempy_law_hysteretic(c, memory, f)


def law_viscous(c, memory, f):
    """Friction of a dashpot: -ct v_t, limited by Coulomb's law; [MIL] 4.3. No contact history, so that contacts creep
    under a tangential load.
    """
    return _lib.dempy_law_viscous(c, memory, f)


def law_step(c, memory, f):
    """Friction of a spring that is stretched for one step only, and a dashpot: -kt (v_t dt) - ct v_t, limited by
    Coulomb's law; [MIL] 4.2. No contact history.
    """
    return _lib.dempy_law_step(c, memory, f)


def law_spring(c, memory, f):
    """Friction of a spring and a dashpot [CS79]: -kt s - ct v_t, limited by Coulomb's law, where s is the tangential
    displacement since the contact began, rotated with the contact plane. With Hertz's law kt follows the present
    overlap. Contact history: 3 reals, the vector s [m].
    """
    return _lib.dempy_law_spring(c, memory, f)


def law_mindlin(c, memory, f):
    """Mindlin's friction by increments [DIR05]: s - ct v_t, limited by Coulomb's law, where the force s changes by -kt
    ds in a step. Differs from [DIR05] in kt: it is that of the overlap in the middle of the step, which makes the law
    of second order in dt. Contact history: 4 reals, the vector s [N] and kt of the last step [N/m].
    """
    return _lib.dempy_law_mindlin(c, memory, f)


def law_mindlin_rescaled(c, memory, f):
    """Mindlin's friction, rescaled on unloading [THO13]: as dem.law_mindlin, but while kt falls the force s is
    multiplied by kt/(kt of the last step), so that the displacement s/kt is kept. A change of the load of a sheared
    contact then creates no energy. Contact history as for dem.law_mindlin.
    """
    return _lib.dempy_law_mindlin_rescaled(c, memory, f)


def law_roll_step(c, memory, f):
    """Rolling resistance of [MIL] 4.5: a moment mu_r R* min(F, |w|) against the relative spin w, with F in N and w in
    rad/s compared as printed there. It also acts on spin about the normal, and holds nothing at rest. No contact
    history.
    """
    return _lib.dempy_law_roll_step(c, memory, f)


def law_roll_constant(c, memory, f):
    """Rolling resistance of constant magnitude [ZHO99]: a moment mu_r R* F against the relative spin in the contact
    plane, and at rest any moment up to that. Differs from [ZHO99] at rest, where its moment is undefined: a spring
    acts in parallel with a dashpot behind the limit. It is as stiff as a step can resolve, kr = (0.3/dt)^2 I with I =
    2/5 m* R*^2, and critically damped. It yields in proportion to dt^2 and does not creep. Contact history: 3 reals,
    the vector of its moment [N m].
    """
    return _lib.dempy_law_roll_constant(c, memory, f)


def law_roll_epsd(c, memory, f):
    """Rolling resistance of an elastic-plastic spring and a dashpot (EPSD) [AI11]. The spring has the stiffness kr =
    2.25 k (mu_r R*)^2, where k = dF/dd is the normal stiffness (hysteretic law: kn), and its moment is limited to
    mu_r R* F. Below the limit a dashpot acts with 0.3 times the critical damping of I = 7/5 m* R*^2. Contact history:
    3 reals, the vector of the spring's moment [N m].
    """
    return _lib.dempy_law_roll_epsd(c, memory, f)


def law_twist(c, memory, f):
    """Twisting (spinning) friction: a moment about the normal of at most mu_spin R* F against the relative spin about
    the normal, and at rest any moment up to that, as with impulses. A spring acts in parallel with a dashpot behind
    the limit. As in dem.law_roll_constant it is as stiff as a step can resolve, k = (0.3/dt)^2 I with I = 2/5 m*
    R*^2, and critically damped. So it holds a grain at rest and does not limit the time step. It adds to the moment
    of a rolling law. Contact history: 1 real, the moment of the spring [N m]; it does not change its sign if a and b
    are exchanged.
    """
    return _lib.dempy_law_twist(c, memory, f)


def result_name(result):
    """Returns a short text for a result, such as "out of memory"."""
    return (_lib.dem_result_name_get(_enum_of(result, Result, 'dem.result_name: result')) or b'').decode()


def ellipsoids_contact(a, b, lambda_=0):
    """Returns the contact of two ellipsoids. lambda is an initial guess, or 0.

    Returns: EllipsoidContact
    """
    a = _struct_of(Ellipsoid, a, 'dem.ellipsoids_contact: a')
    b = _struct_of(Ellipsoid, b, 'dem.ellipsoids_contact: b')
    return _lib.dem_ellipsoids_contact_get(a, b, lambda_)


def trials_print(trials, out=None):
    """Prints the trials as a table, and the advice."""
    trials = _struct_of(Trials, trials, 'dem.trials_print: trials')
    return Handle()._print(_lib.dem_trials_print, out, trials)


_CONSTANTS = {      # constants of enums, as error messages of Python show them
    'DEM_BOUNDARY_OPEN': "'open'",
    'DEM_BOUNDARY_OUTFLOW': "'outflow'",
    'DEM_BOUNDARY_PERIODIC': "'periodic'",
    'DEM_CLUSTER_CONTACTS_MERGED': "'merged'",
    'DEM_CLUSTER_CONTACTS_SEPARATE': "'separate'",
    'DEM_CLUSTER_GIVEN': "'given'",
    'DEM_CLUSTER_SUM': "'sum'",
    'DEM_CLUSTER_UNION': "'union'",
    'DEM_CONE_CONVEX': "'convex'",
    'DEM_CONE_COULOMB': "'coulomb'",
    'DEM_CONVENTION_MILL': "'mill'",
    'DEM_CONVENTION_STANDARD': "'standard'",
    'DEM_EDGE_FRACTION': "'fraction'",
    'DEM_EDGE_RESOLVED': "'resolved'",
    'DEM_EFFECT_ACTIVE': "'active'",
    'DEM_EFFECT_IDLE': "'idle'",
    'DEM_EFFECT_OFF': "'off'",
    'DEM_EVENT_BEGIN': "'begin'",
    'DEM_EVENT_END': "'end'",
    'DEM_EVENT_OPEN': "'open'",
    'DEM_INTEGRATOR_FORWARD_EULER': "'forward_euler'",
    'DEM_INTEGRATOR_LEAPFROG': "'leapfrog'",
    'DEM_INTEGRATOR_POSITION_VERLET': "'position_verlet'",
    'DEM_INTEGRATOR_SYMPLECTIC_EULER': "'symplectic_euler'",
    'DEM_INTEGRATOR_VELOCITY_VERLET': "'velocity_verlet'",
    'DEM_JOINT_NONE': "'none'",
    'DEM_JOINT_POINT': "'point'",
    'DEM_JOINT_REVOLUTE': "'revolute'",
    'DEM_LOAD_ELASTIC': "'elastic'",
    'DEM_LOAD_MAGNITUDE': "'magnitude'",
    'DEM_LOAD_REPULSIVE': "'repulsive'",
    'DEM_MOTION_FIXED': "'fixed'",
    'DEM_MOTION_OSCILLATING': "'oscillating'",
    'DEM_MOTION_ROTATING': "'rotating'",
    'DEM_MOTION_SERVO': "'servo'",
    'DEM_MOTION_TABLE': "'table'",
    'DEM_MOTION_TRANSLATING': "'translating'",
    'DEM_MOTION_USER': "'user'",
    'DEM_MOTOR_NONE': "'none'",
    'DEM_MOTOR_SPEED': "'speed'",
    'DEM_MOTOR_TORQUE': "'torque'",
    'DEM_NORMAL_HERTZ': "'hertz'",
    'DEM_NORMAL_HYSTERETIC': "'hysteretic'",
    'DEM_NORMAL_LINEAR': "'linear'",
    'DEM_OUTPUT_BODIES_CSV': "'bodies_csv'",
    'DEM_OUTPUT_CALL': "'call'",
    'DEM_OUTPUT_CHECKPOINT': "'checkpoint'",
    'DEM_OUTPUT_CONTACTS': "'contacts'",
    'DEM_OUTPUT_CONTACTS_CSV': "'contacts_csv'",
    'DEM_OUTPUT_CSV': "'csv'",
    'DEM_OUTPUT_FIELD_CSV': "'field_csv'",
    'DEM_OUTPUT_SURFACES': "'surfaces'",
    'DEM_OUTPUT_VTP': "'vtp'",
    'DEM_OUTPUT_WALLS': "'walls'",
    'DEM_OUTPUT_XYZ': "'xyz'",
    'DEM_OVERLAP_CHORD': "'chord'",
    'DEM_OVERLAP_CONSERVATIVE': "'conservative'",
    'DEM_OVERLAP_NORMAL': "'normal'",
    'DEM_RESPONSE_IMPULSES': "'impulses'",
    'DEM_RESPONSE_SPRINGS': "'springs'",
    'DEM_ROLLING_AUTO': "'auto'",
    'DEM_ROLLING_CONSTANT': "'constant'",
    'DEM_ROLLING_EPSD': "'epsd'",
    'DEM_ROLLING_NONE': "'none'",
    'DEM_ROLLING_STEP': "'step'",
    'DEM_ROTATION_FINCHAM': "'fincham'",
    'DEM_ROTATION_NO_SQUISH': "'no_squish'",
    'DEM_ROTATION_SPIRAL': "'spiral'",
    'DEM_SEARCH_ALL_PAIRS': "'all_pairs'",
    'DEM_SEARCH_AUTO': "'auto'",
    'DEM_SEARCH_BINS': "'bins'",
    'DEM_SEARCH_GRID': "'grid'",
    'DEM_SEARCH_HIERARCHICAL': "'hierarchical'",
    'DEM_SEARCH_LINKED_LIST': "'linked_list'",
    'DEM_SEVERITY_ERROR': "'error'",
    'DEM_SEVERITY_NOTE': "'note'",
    'DEM_SEVERITY_WARNING': "'warning'",
    'DEM_SIEVE_BARS': "'bars'",
    'DEM_SIEVE_NONE': "'none'",
    'DEM_SIEVE_REDUCED': "'reduced'",
    'DEM_SIEVE_ROUND': "'round'",
    'DEM_SIEVE_SLOTS': "'slots'",
    'DEM_SIEVE_SQUARE': "'square'",
    'DEM_SIEVE_WIRES': "'wires'",
    'DEM_SIZES_EXPONENTIAL': "'exponential'",
    'DEM_SIZES_LOGNORMAL': "'lognormal'",
    'DEM_SIZES_NORMAL': "'normal'",
    'DEM_SIZES_SIEVE_CURVE': "'sieve_curve'",
    'DEM_SIZES_UNIFORM': "'uniform'",
    'DEM_SIZES_WEIBULL': "'weibull'",
    'DEM_SLIDER_PARALLEL': "'parallel'",
    'DEM_SLIDER_REMAINDER': "'remainder'",
    'DEM_SLIDER_SPRING': "'spring'",
    'DEM_SOLVER_APGD': "'apgd'",
    'DEM_SOLVER_GAUSS_SEIDEL': "'gauss_seidel'",
    'DEM_SOLVER_JACOBI': "'jacobi'",
    'DEM_SOLVER_SPECTRAL': "'spectral'",
    'DEM_TANGENT_AUTO': "'auto'",
    'DEM_TANGENT_MINDLIN': "'mindlin'",
    'DEM_TANGENT_MINDLIN_RESCALED': "'mindlin_rescaled'",
    'DEM_TANGENT_NONE': "'none'",
    'DEM_TANGENT_SPRING': "'spring'",
    'DEM_TANGENT_STEP': "'step'",
    'DEM_TANGENT_VISCOUS': "'viscous'",
    'DEM_TENSION_ALLOWED': "'allowed'",
    'DEM_TENSION_CLIPPED': "'clipped'",
    'DEM_TENSION_COMPENSATED': "'compensated'",
}


_FUNCTIONS = [
    ('dem_world_create_checked', ctypes.c_void_p, [ctypes.POINTER(WorldDesc), ctypes.c_int, ctypes.c_size_t], 'World',
     ['desc', 'version', 'real_size']),
    ('dem_quat_about', Quat, [Vec3, Real], 'quat_about', ['axis', 'angle']),
    ('dempy_quat_multiply', Quat, [Quat, Quat], 'quat_multiply', ['a', 'b']),
    ('dempy_quat_rotate', Vec3, [Quat, Vec3], 'quat_rotate', ['q', 'v']),
    ('dempy_quat_unrotate', Vec3, [Quat, Vec3], 'quat_unrotate', ['q', 'v']),
    ('dempy_memory_rotate', Vec3, [ctypes.POINTER(Contact), Vec3], 'memory_rotate', ['c', 'v']),
    ('dempy_law_load', None, [ctypes.POINTER(Contact), ctypes.POINTER(ContactForce), Real], 'law_load', ['c', 'f',
     'hold']),
    ('dempy_law_hertz', None, [ctypes.POINTER(Contact), ctypes.POINTER(Real), ctypes.POINTER(ContactForce)],
     'law_hertz', ['c', 'memory', 'f']),
    ('dempy_law_linear', None, [ctypes.POINTER(Contact), ctypes.POINTER(Real), ctypes.POINTER(ContactForce)],
     'law_linear', ['c', 'memory', 'f']),
    ('dempy_law_hysteretic', None, [ctypes.POINTER(Contact), ctypes.POINTER(Real), ctypes.POINTER(ContactForce)],
     'law_hysteretic', ['c', 'memory', 'f']),
    ('dempy_law_viscous', None, [ctypes.POINTER(Contact), ctypes.POINTER(Real), ctypes.POINTER(ContactForce)],
     'law_viscous', ['c', 'memory', 'f']),
    ('dempy_law_step', None, [ctypes.POINTER(Contact), ctypes.POINTER(Real), ctypes.POINTER(ContactForce)],
     'law_step', ['c', 'memory', 'f']),
    ('dempy_law_spring', None, [ctypes.POINTER(Contact), ctypes.POINTER(Real), ctypes.POINTER(ContactForce)],
     'law_spring', ['c', 'memory', 'f']),
    ('dempy_law_mindlin', None, [ctypes.POINTER(Contact), ctypes.POINTER(Real), ctypes.POINTER(ContactForce)],
     'law_mindlin', ['c', 'memory', 'f']),
    ('dempy_law_mindlin_rescaled', None, [ctypes.POINTER(Contact), ctypes.POINTER(Real),
     ctypes.POINTER(ContactForce)], 'law_mindlin_rescaled', ['c', 'memory', 'f']),
    ('dempy_law_roll_step', None, [ctypes.POINTER(Contact), ctypes.POINTER(Real), ctypes.POINTER(ContactForce)],
     'law_roll_step', ['c', 'memory', 'f']),
    ('dempy_law_roll_constant', None, [ctypes.POINTER(Contact), ctypes.POINTER(Real), ctypes.POINTER(ContactForce)],
     'law_roll_constant', ['c', 'memory', 'f']),
    ('dempy_law_roll_epsd', None, [ctypes.POINTER(Contact), ctypes.POINTER(Real), ctypes.POINTER(ContactForce)],
     'law_roll_epsd', ['c', 'memory', 'f']),
    ('dempy_law_twist', None, [ctypes.POINTER(Contact), ctypes.POINTER(Real), ctypes.POINTER(ContactForce)],
     'law_twist', ['c', 'memory', 'f']),
    ('dem_world_create_error_get', ctypes.c_char_p, [ctypes.POINTER(WorldDesc)], 'world_create_error', ['desc']),
    ('dem_world_destroy', None, [ctypes.c_void_p], 'World.destroy', ['self']),
    ('dem_world_error_get', ctypes.c_char_p, [ctypes.c_void_p], 'World.error', ['self']),
    ('dem_result_name_get', ctypes.c_char_p, [ctypes.c_int], 'result_name', ['result']),
    ('dem_world_desc_get', WorldDesc, [ctypes.c_void_p], 'World.desc', ['self']),
    ('dem_material_add', Material, [ctypes.c_void_p, ctypes.POINTER(MaterialDesc)], 'World.material', ['self',
     'desc']),
    ('dem_material_set', ctypes.c_int, [ctypes.c_void_p, Material, ctypes.POINTER(MaterialDesc)], 'Material.set',
     ['self', 'self', 'desc']),
    ('dem_material_get', ctypes.c_int, [ctypes.c_void_p, Material, ctypes.POINTER(MaterialDesc)], 'Material.desc',
     ['self', 'self', 'desc']),
    ('dem_pair_get', ctypes.c_int, [ctypes.c_void_p, Material, Material, ctypes.POINTER(Pair)], 'World.pair', ['self',
     'a', 'b', 'pair']),
    ('dem_pair_set', ctypes.c_int, [ctypes.c_void_p, Material, Material, ctypes.POINTER(Pair)], 'World.pair_set',
     ['self', 'a', 'b', 'pair']),
    ('dem_coefficients_get', ctypes.c_int, [ctypes.c_void_p, Material, Material, Real, Real,
     ctypes.POINTER(Coefficients)], 'World.coefficients', ['self', 'a', 'b', 'radius_a', 'radius_b', 'out']),
    ('dem_pairs_print', None, [ctypes.c_void_p, ctypes.c_void_p], 'World.pairs_print', ['self', 'out']),
    ('dem_sphere_add', Body, [ctypes.c_void_p, Material, Real, Vec3], 'World.sphere', ['self', 'material', 'radius',
     'position']),
    ('dem_spheres_add', ctypes.c_int, [ctypes.c_void_p, Material, ctypes.c_int, ctypes.POINTER(Real),
     ctypes.POINTER(Real), ctypes.POINTER(Real), Real], 'World.spheres', ['self', 'material', 'count', 'positions',
     'velocities', 'radii', 'radius']),
    ('dem_spheres_fill', ctypes.c_int, [ctypes.c_void_p, Material, Real, Region, ctypes.c_int, ctypes.c_uint64],
     'World.spheres_fill', ['self', 'material', 'radius', 'region', 'count', 'seed']),
    ('dem_sizes_finer_get', ctypes.c_double, [ctypes.c_void_p, ctypes.POINTER(Sizes), Real], 'World.sizes_finer',
     ['self', 'sizes', 'radius']),
    ('dem_sizes_draw', ctypes.c_int, [ctypes.c_void_p, ctypes.POINTER(Sizes), ctypes.c_int, ctypes.c_uint64,
     ctypes.POINTER(Real)], 'World.sizes_draw', ['self', 'sizes', 'count', 'seed', 'radii']),
    ('dem_sizes_classes_get', ctypes.c_int, [ctypes.c_void_p, ctypes.POINTER(Sizes), ctypes.c_int,
     ctypes.POINTER(Real), ctypes.POINTER(ctypes.c_double)], 'World.sizes_classes', ['self', 'sizes', 'class_count',
     'radius', 'amount']),
    ('dem_sizes_fill', ctypes.c_int, [ctypes.c_void_p, Material, ctypes.POINTER(Sizes), Region, ctypes.c_int,
     ctypes.c_uint64], 'World.sizes_fill', ['self', 'material', 'sizes', 'region', 'count', 'seed']),
    ('dem_spheres_pack', ctypes.c_int, [ctypes.c_void_p, Material, Real, Real, Region, ctypes.c_int],
     'World.spheres_pack', ['self', 'material', 'radius', 'padding', 'region', 'count']),
    ('dem_body_remove', ctypes.c_int, [ctypes.c_void_p, Body], 'Body.remove', ['self', 'self']),
    ('dem_body_get', ctypes.c_int, [ctypes.c_void_p, Body, ctypes.POINTER(BodyState)], 'Body.state', ['self', 'self',
     'state']),
    ('dem_body_set', ctypes.c_int, [ctypes.c_void_p, Body, ctypes.POINTER(BodyState)], 'Body.set', ['self', 'self',
     'state']),
    ('dem_body_radius_set', ctypes.c_int, [ctypes.c_void_p, Body, Real], 'Body.radius_set', ['self', 'self',
     'radius']),
    ('dem_temperature_get', ctypes.c_double, [ctypes.c_void_p], 'World.temperature', ['self']),
    ('dem_temperature_set', ctypes.c_int, [ctypes.c_void_p, ctypes.c_double, ctypes.c_uint64],
     'World.temperature_set', ['self', 'temperature', 'seed']),
    ('dem_bodies_get', Bodies, [ctypes.c_void_p], 'World.bodies_memory', ['self']),
    ('dem_body_id_get', Body, [ctypes.c_void_p, ctypes.c_int], 'World.body_id', ['self', 'index']),
    ('dem_group_get', Group, [ctypes.c_void_p, ctypes.c_char_p], 'World.group', ['self', 'name']),
    ('dem_bodies_select', ctypes.c_int, [ctypes.c_void_p, ctypes.POINTER(Selection), ctypes.POINTER(Body),
     ctypes.c_int], 'World.bodies_select', ['self', 'selection', 'out', 'capacity']),
    ('dem_bodies_group_set', ctypes.c_int, [ctypes.c_void_p, ctypes.POINTER(Selection), Group, ctypes.c_int],
     'World.bodies_group_set', ['self', 'selection', 'group', 'member']),
    ('dem_bodies_velocity_set', ctypes.c_int, [ctypes.c_void_p, ctypes.POINTER(Selection), Vec3, Vec3],
     'World.bodies_velocity_set', ['self', 'selection', 'velocity', 'spin']),
    ('dem_bodies_fixed_set', ctypes.c_int, [ctypes.c_void_p, ctypes.POINTER(Selection), ctypes.c_int],
     'World.bodies_fixed_set', ['self', 'selection', 'fixed']),
    ('dem_bodies_remove', ctypes.c_int, [ctypes.c_void_p, ctypes.POINTER(Selection)], 'World.bodies_remove', ['self',
     'selection']),
    ('dem_bodies_means_get', ctypes.c_int, [ctypes.c_void_p, ctypes.POINTER(Selection), ctypes.POINTER(BodiesMeans)],
     'World.bodies_means', ['self', 'selection', 'means']),
    ('dem_body_reals_get', ctypes.c_int, [ctypes.c_void_p, Body, ctypes.POINTER(Real)], 'Body.reals', ['self', 'self',
     'reals']),
    ('dem_body_reals_set', ctypes.c_int, [ctypes.c_void_p, Body, ctypes.POINTER(Real)], 'Body.reals_set', ['self',
     'self', 'reals']),
    ('dem_bodies_reals_set', ctypes.c_int, [ctypes.c_void_p, ctypes.POINTER(Real)], 'World.bodies_reals_set', ['self',
     'reals']),
    ('dem_wall_reals_get', ctypes.c_int, [ctypes.c_void_p, Wall, ctypes.POINTER(Real)], 'Wall.reals', ['self', 'self',
     'reals']),
    ('dem_wall_reals_set', ctypes.c_int, [ctypes.c_void_p, Wall, ctypes.POINTER(Real)], 'Wall.reals_set', ['self',
     'self', 'reals']),
    ('dem_shape_ellipsoid_add', Shape, [ctypes.c_void_p, Vec3], 'World.shape_ellipsoid', ['self', 'semi_axes']),
    ('dem_shape_cluster_add', Shape, [ctypes.c_void_p, ctypes.POINTER(ClusterDesc)], 'World.shape_cluster', ['self',
     'desc']),
    ('dem_shape_polyhedron_add', Shape, [ctypes.c_void_p, ctypes.c_int, ctypes.POINTER(Real)],
     'World.shape_polyhedron', ['self', 'count', 'points']),
    ('dem_shape_mesh_add', Shape, [ctypes.c_void_p, ctypes.POINTER(Mesh), Real], 'World.shape_mesh', ['self', 'mesh',
     'dent']),
    ('dem_shape_union_add', Shape, [ctypes.c_void_p, ctypes.c_int, ctypes.POINTER(Shape), ctypes.POINTER(Real),
     ctypes.POINTER(Real)], 'World.shape_union', ['self', 'count', 'shapes', 'positions', 'orientations']),
    ('dem_shape_polygon_add', Shape, [ctypes.c_void_p, ctypes.c_int, ctypes.POINTER(Real)], 'World.shape_polygon',
     ['self', 'count', 'points']),
    ('dem_shape_get', ctypes.c_int, [ctypes.c_void_p, Shape, ctypes.POINTER(ShapeInfo)], 'Shape.info', ['self',
     'self', 'info']),
    ('dem_body_add', Body, [ctypes.c_void_p, Material, Shape, Vec3, Quat], 'World.body', ['self', 'material', 'shape',
     'position', 'orientation']),
    ('dem_bodies_add', ctypes.c_int, [ctypes.c_void_p, Material, Shape, ctypes.c_int, ctypes.POINTER(Real),
     ctypes.POINTER(Real), ctypes.POINTER(Real), ctypes.POINTER(Real), ctypes.POINTER(Real)], 'World.bodies_add',
     ['self', 'material', 'shape', 'count', 'positions', 'orientations', 'velocities', 'spins', 'scales']),
    ('dem_bodies_fill', ctypes.c_int, [ctypes.c_void_p, Material, Shape, Region, ctypes.c_int, ctypes.c_uint64],
     'World.bodies_fill', ['self', 'material', 'shape', 'region', 'count', 'seed']),
    ('dem_ellipsoids_contact_get', EllipsoidContact, [ctypes.POINTER(Ellipsoid), ctypes.POINTER(Ellipsoid), Real],
     'ellipsoids_contact', ['a', 'b', 'lambda_']),
    ('dem_body_counts_get', BodyCounts, [ctypes.c_void_p], 'World.body_counts', ['self']),
    ('dem_wall_plane_add', Wall, [ctypes.c_void_p, Material, Vec3, Vec3], 'World.wall_plane', ['self', 'material',
     'point', 'normal']),
    ('dem_wall_cylinder_add', Wall, [ctypes.c_void_p, Material, Vec3, Vec3, Real, ctypes.c_int],
     'World.wall_cylinder', ['self', 'material', 'point', 'axis', 'radius', 'inside']),
    ('dem_wall_revolved_add', Wall, [ctypes.c_void_p, Material, Vec3, Vec3, ctypes.c_int, ctypes.POINTER(Real),
     ctypes.POINTER(Real)], 'World.wall_revolved', ['self', 'material', 'point', 'axis', 'count', 'radii',
     'heights']),
    ('dem_wall_cone_add', Wall, [ctypes.c_void_p, Material, Vec3, Vec3, Real, Real], 'World.wall_cone', ['self',
     'material', 'from_', 'to', 'radius_from', 'radius_to']),
    ('dem_wall_profile_add', Wall, [ctypes.c_void_p, Material, ctypes.POINTER(Profile), ctypes.c_int],
     'World.wall_profile', ['self', 'material', 'profile', 'rule']),
    ('dem_wall_mesh_add', Wall, [ctypes.c_void_p, Material, ctypes.POINTER(Mesh)], 'World.wall_mesh', ['self',
     'material', 'mesh']),
    ('dem_wall_grains_add', Wall, [ctypes.c_void_p, Material, ctypes.c_int, ctypes.POINTER(Real), Real, Real],
     'World.wall_grains', ['self', 'material', 'count', 'positions', 'radius', 'share']),
    ('dem_wall_sieve_add', Wall, [ctypes.c_void_p, Material, ctypes.POINTER(SieveDesc)], 'World.wall_sieve', ['self',
     'material', 'desc']),
    ('dem_sieve_blinded_get', ctypes.c_int, [ctypes.c_void_p, Wall, Real], 'World.sieve_blinded', ['self', 'sieve',
     'speed']),
    ('dem_wall_motion_set', ctypes.c_int, [ctypes.c_void_p, Wall, ctypes.POINTER(Motion)], 'Wall.motion_set', ['self',
     'self', 'motion']),
    ('dem_wall_surface_velocity_set', ctypes.c_int, [ctypes.c_void_p, Wall, Vec3], 'Wall.surface_velocity_set',
     ['self', 'self', 'velocity']),
    ('dem_wall_surface_velocity_get', ctypes.c_int, [ctypes.c_void_p, Wall, ctypes.POINTER(Vec3)],
     'Wall.surface_velocity', ['self', 'self', 'velocity']),
    ('dem_wall_pose_get', ctypes.c_int, [ctypes.c_void_p, Wall, ctypes.POINTER(Pose)], 'Wall.pose', ['self', 'self',
     'pose']),
    ('dem_wall_remove', ctypes.c_int, [ctypes.c_void_p, Wall], 'Wall.remove', ['self', 'self']),
    ('dem_wall_loads_get', ctypes.c_int, [ctypes.c_void_p, Wall, ctypes.POINTER(WallLoads)], 'Wall.loads', ['self',
     'self', 'loads']),
    ('dem_wall_loads_reset', ctypes.c_int, [ctypes.c_void_p, Wall], 'Wall.loads_reset', ['self', 'self']),
    ('dem_joint_add', Joint, [ctypes.c_void_p, ctypes.POINTER(JointDesc)], 'World.joint', ['self', 'desc']),
    ('dem_joint_motor_set', ctypes.c_int, [ctypes.c_void_p, Joint, ctypes.c_int, Real, Real], 'Joint.motor_set',
     ['self', 'self', 'motor', 'speed', 'torque']),
    ('dem_joint_get', ctypes.c_int, [ctypes.c_void_p, Joint, ctypes.POINTER(JointState)], 'Joint.state', ['self',
     'self', 'state']),
    ('dem_joint_remove', ctypes.c_int, [ctypes.c_void_p, Joint], 'Joint.remove', ['self', 'self']),
    ('dem_body_rail_set', ctypes.c_int, [ctypes.c_void_p, Body, ctypes.POINTER(RailDesc)], 'Body.rail_set', ['self',
     'self', 'desc']),
    ('dem_body_reaction_get', ctypes.c_int, [ctypes.c_void_p, Body, ctypes.POINTER(RailState)], 'Body.reaction',
     ['self', 'self', 'state']),
    ('dem_feed_add', Feed, [ctypes.c_void_p, ctypes.POINTER(FeedDesc)], 'World.feed', ['self', 'desc']),
    ('dem_feed_get', ctypes.c_int, [ctypes.c_void_p, Feed, ctypes.POINTER(FeedState)], 'Feed.state', ['self', 'self',
     'state']),
    ('dem_outlet_add', Outlet, [ctypes.c_void_p, ctypes.POINTER(OutletDesc)], 'World.outlet', ['self', 'desc']),
    ('dem_outlet_get', ctypes.c_int, [ctypes.c_void_p, Outlet, ctypes.POINTER(OutletState)], 'Outlet.state', ['self',
     'self', 'state']),
    ('dem_outlet_reset', ctypes.c_int, [ctypes.c_void_p, Outlet], 'Outlet.reset', ['self', 'self']),
    ('dem_step_advice_get', ctypes.c_int, [ctypes.c_void_p, ctypes.POINTER(Advice)], 'World.step_advice', ['self',
     'advice']),
    ('dem_world_check', ctypes.c_int, [ctypes.c_void_p, ctypes.POINTER(Finding), ctypes.c_int], 'World.check',
     ['self', 'findings', 'capacity']),
    ('dem_world_check_print', ctypes.c_int, [ctypes.c_void_p, ctypes.c_void_p], 'World.check_print', ['self', 'out']),
    ('dem_world_step', ctypes.c_int, [ctypes.c_void_p, ctypes.c_int], 'World.step', ['self', 'steps']),
    ('dem_world_run', ctypes.c_int, [ctypes.c_void_p, ctypes.c_double, ProgressFn.c, ctypes.c_void_p], 'World.run',
     ['self', 'seconds', 'progress', 'user=']),
    ('dem_world_run_to', ctypes.c_int, [ctypes.c_void_p, ctypes.c_double, ProgressFn.c, ctypes.c_void_p],
     'World.run_to', ['self', 'time', 'progress', 'user=']),
    ('dem_world_settle', ctypes.c_int, [ctypes.c_void_p, ctypes.c_double, Real, ProgressFn.c, ctypes.c_void_p],
     'World.settle', ['self', 'seconds', 'speed', 'progress', 'user=']),
    ('dem_progress_print', ctypes.c_int, [ctypes.c_void_p, ctypes.c_double, ctypes.c_double, ctypes.c_void_p],
     'World.progress_print', ['self', 'done', 'seconds_left', 'user=']),
    ('dem_world_gravity_set', ctypes.c_int, [ctypes.c_void_p, Vec3], 'World.gravity_set', ['self', 'gravity']),
    ('dem_cell_set', ctypes.c_int, [ctypes.c_void_p, ctypes.POINTER(CellDesc)], 'World.cell_set', ['self', 'desc']),
    ('dem_cell_state_get', ctypes.c_int, [ctypes.c_void_p, ctypes.POINTER(CellState)], 'World.cell_state', ['self',
     'state']),
    ('dem_world_dt_set', ctypes.c_int, [ctypes.c_void_p, Real], 'World.dt_set', ['self', 'dt']),
    ('dem_world_time_get', ctypes.c_double, [ctypes.c_void_p], 'World.time', ['self']),
    ('dem_world_steps_get', ctypes.c_uint64, [ctypes.c_void_p], 'World.steps', ['self']),
    ('dem_world_hash_get', ctypes.c_uint64, [ctypes.c_void_p], 'World.hash', ['self']),
    ('dem_counters_get', Counters, [ctypes.c_void_p], 'World.counters', ['self']),
    ('dem_overlap_max_reset', None, [ctypes.c_void_p], 'World.overlap_max_reset', ['self']),
    ('dem_ledger_get', Ledger, [ctypes.c_void_p], 'World.ledger', ['self']),
    ('dem_totals_get', Totals, [ctypes.c_void_p], 'World.totals', ['self']),
    ('dem_observer_height', ctypes.c_double, [ctypes.c_void_p, ctypes.c_void_p], 'World.observer_height', ['self',
     'user=']),
    ('dem_observer_kinetic', ctypes.c_double, [ctypes.c_void_p, ctypes.c_void_p], 'World.observer_kinetic', ['self',
     'user=']),
    ('dem_observer_contacts', ctypes.c_double, [ctypes.c_void_p, ctypes.c_void_p], 'World.observer_contacts', ['self',
     'user=']),
    ('dem_observer_walls', ctypes.c_double, [ctypes.c_void_p, ctypes.c_void_p], 'World.observer_walls', ['self',
     'user=']),
    ('dem_trials_run', ctypes.c_int, [ctypes.c_void_p, ctypes.POINTER(TrialsDesc), ctypes.POINTER(Trials)],
     'World.trials_run', ['self', 'desc', 'trials']),
    ('dem_trials_print', None, [ctypes.POINTER(Trials), ctypes.c_void_p], 'trials_print', ['trials', 'out']),
    ('dem_contacts_get', ctypes.c_int, [ctypes.c_void_p, ctypes.POINTER(ContactInfo), ctypes.c_int], 'World.contacts',
     ['self', 'out', 'capacity']),
    ('dem_contacts_each', ctypes.c_int, [ctypes.c_void_p, ContactFn.c, ctypes.c_void_p], 'World.contacts_each',
     ['self', 'fn', 'user=']),
    ('dem_bonds_make', ctypes.c_int, [ctypes.c_void_p, Real, ContactFn.c, ctypes.c_void_p], 'World.bonds_make',
     ['self', 'gap', 'make', 'user=']),
    ('dem_candidates_get', ctypes.c_int, [ctypes.c_void_p, ctypes.POINTER(ctypes.c_uint32), ctypes.c_int],
     'World.candidates', ['self', 'out', 'capacity']),
    ('dem_candidates_rebuild', ctypes.c_int, [ctypes.c_void_p], 'World.candidates_rebuild', ['self']),
    ('dem_events_record', ctypes.c_int, [ctypes.c_void_p, ctypes.POINTER(EventsDesc)], 'World.events_record', ['self',
     'desc']),
    ('dem_events_stop', ctypes.c_int, [ctypes.c_void_p], 'World.events_stop', ['self']),
    ('dem_events_open_each', ctypes.c_int, [ctypes.c_void_p, EventFn.c, ctypes.c_void_p], 'World.events_open_each',
     ['self', 'fn', 'user=']),
    ('dem_impacts_get', ctypes.c_int, [ctypes.c_void_p, Material, Material, ctypes.POINTER(Impacts)], 'World.impacts',
     ['self', 'a=', 'b=', 'impacts']),
    ('dem_impacts_csv_write', ctypes.c_int, [ctypes.c_void_p, ctypes.c_char_p], 'World.impacts_csv_write', ['self',
     'path']),
    ('dem_wall_wear_get', ctypes.c_int, [ctypes.c_void_p, Wall, ctypes.c_double, ctypes.c_double,
     ctypes.POINTER(Wear)], 'Wall.wear', ['self', 'self', 'coefficient', 'hardness', 'wear']),
    ('dem_wall_wear_facets_get', ctypes.c_int, [ctypes.c_void_p, Wall, ctypes.POINTER(ctypes.c_double), ctypes.c_int],
     'Wall.wear_facets', ['self', 'self', 'work', 'capacity']),
    ('dem_wall_servo_get', ctypes.c_int, [ctypes.c_void_p, Wall, ctypes.POINTER(Servo)], 'Wall.servo', ['self',
     'self', 'servo']),
    ('dem_stress_get', ctypes.c_int, [ctypes.c_void_p, ctypes.POINTER(Stress)], 'World.stress', ['self', 'stress']),
    ('dem_field_add', Field, [ctypes.c_void_p, ctypes.POINTER(FieldDesc)], 'World.field', ['self', 'desc']),
    ('dem_field_get', ctypes.c_int, [ctypes.c_void_p, Field, ctypes.POINTER(FieldData)], 'Field.data', ['self',
     'self', 'data']),
    ('dem_field_cell_get', ctypes.c_int, [ctypes.c_void_p, Field, ctypes.c_int, ctypes.c_int, ctypes.c_int,
     ctypes.POINTER(FieldCell)], 'Field.cell', ['self', 'self', 'i', 'j', 'k', 'cell']),
    ('dem_body_means_get', ctypes.c_int, [ctypes.c_void_p, Body, ctypes.POINTER(BodyMeans)], 'Body.means', ['self',
     'self', 'means']),
    ('dem_field_reset', ctypes.c_int, [ctypes.c_void_p, Field], 'Field.reset', ['self', 'self']),
    ('dem_mixing_get', ctypes.c_int, [ctypes.c_void_p, ctypes.POINTER(MixingDesc), ctypes.POINTER(Mixing)],
     'World.mixing', ['self', 'desc', 'mixing']),
    ('dem_repose_heap_get', ctypes.c_int, [ctypes.c_void_p, Box, ctypes.POINTER(Repose)], 'World.repose_heap',
     ['self', 'box=', 'repose']),
    ('dem_repose_drum_get', ctypes.c_int, [ctypes.c_void_p, Box, Vec3, ctypes.POINTER(Repose)], 'World.repose_drum',
     ['self', 'box', 'axis', 'repose']),
    ('dem_mesh_read', ctypes.c_int, [ctypes.c_void_p, ctypes.c_char_p, ctypes.POINTER(Mesh),
     ctypes.POINTER(MeshHealth)], 'World.mesh_read', ['self', 'path', 'mesh', 'health']),
    ('dem_mesh_parse', ctypes.c_int, [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p, ctypes.c_size_t,
     ctypes.POINTER(Mesh), ctypes.POINTER(MeshHealth)], 'World.mesh_parse', ['self', 'name', 'data', 'size', 'mesh',
     'health']),
    ('dem_mesh_part_read', ctypes.c_int, [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_char_p, ctypes.POINTER(Mesh),
     ctypes.POINTER(MeshHealth)], 'World.mesh_part_read', ['self', 'path', 'part', 'mesh', 'health']),
    ('dem_mesh_free', None, [ctypes.c_void_p, ctypes.POINTER(Mesh)], 'World.mesh_free', ['self', 'mesh']),
    ('dem_mesh_place', ctypes.c_int, [ctypes.c_void_p, ctypes.POINTER(Mesh), Real, Quat, Vec3], 'World.mesh_place',
     ['self', 'mesh', 'scale', 'rotation', 'to']),
    ('dem_mesh_spheres', ctypes.c_int, [ctypes.c_void_p, ctypes.POINTER(Mesh), ctypes.c_int, ctypes.POINTER(Real),
     ctypes.POINTER(Real), ctypes.POINTER(SpheresFit)], 'World.mesh_spheres', ['self', 'mesh', 'count', 'positions',
     'radii', 'fit']),
    ('dem_wall_parts_add', ctypes.c_int, [ctypes.c_void_p, ctypes.c_char_p, Real, ctypes.c_int,
     ctypes.POINTER(WallPart), ctypes.POINTER(Wall)], 'World.wall_parts', ['self', 'path', 'scale', 'count', 'parts',
     'walls']),
    ('dem_profile_read', ctypes.c_int, [ctypes.c_void_p, ctypes.c_char_p, ctypes.POINTER(Profile)],
     'World.profile_read', ['self', 'path', 'profile']),
    ('dem_profile_parse', ctypes.c_int, [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p, ctypes.c_size_t,
     ctypes.POINTER(Profile)], 'World.profile_parse', ['self', 'name', 'data', 'size', 'profile']),
    ('dem_profile_free', None, [ctypes.c_void_p, ctypes.POINTER(Profile)], 'World.profile_free', ['self', 'profile']),
    ('dem_grains_read', ctypes.c_int, [ctypes.c_void_p, ctypes.c_char_p, ctypes.POINTER(Grains)], 'World.grains_read',
     ['self', 'path', 'grains']),
    ('dem_grains_parse', ctypes.c_int, [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p, ctypes.c_size_t,
     ctypes.POINTER(Grains)], 'World.grains_parse', ['self', 'name', 'data', 'size', 'grains']),
    ('dem_grains_free', None, [ctypes.c_void_p, ctypes.POINTER(Grains)], 'World.grains_free', ['self', 'grains']),
    ('dem_grains_add', ctypes.c_int, [ctypes.c_void_p, Material, ctypes.POINTER(Grains)], 'World.grains', ['self',
     'material=', 'grains']),
    ('dem_vtp_write', ctypes.c_int, [ctypes.c_void_p, ctypes.c_char_p], 'World.vtp_write', ['self', 'path']),
    ('dem_vtk_write', ctypes.c_int, [ctypes.c_void_p, ctypes.c_char_p], 'World.vtk_write', ['self', 'path']),
    ('dem_xyz_write', ctypes.c_int, [ctypes.c_void_p, ctypes.c_char_p], 'World.xyz_write', ['self', 'path']),
    ('dem_contacts_vtp_write', ctypes.c_int, [ctypes.c_void_p, ctypes.c_char_p], 'World.contacts_vtp_write', ['self',
     'path']),
    ('dem_walls_vtp_write', ctypes.c_int, [ctypes.c_void_p, ctypes.c_char_p, Real, Real], 'World.walls_vtp_write',
     ['self', 'path', 'z0', 'z1']),
    ('dem_surfaces_vtp_write', ctypes.c_int, [ctypes.c_void_p, ctypes.c_char_p], 'World.surfaces_vtp_write', ['self',
     'path']),
    ('dem_wall_loads_csv_write', ctypes.c_int, [ctypes.c_void_p, Wall, ctypes.c_char_p], 'Wall.loads_csv_write',
     ['self', 'self', 'path']),
    ('dem_bodies_csv_write', ctypes.c_int, [ctypes.c_void_p, ctypes.c_char_p], 'World.bodies_csv_write', ['self',
     'path']),
    ('dem_contacts_csv_write', ctypes.c_int, [ctypes.c_void_p, ctypes.c_char_p], 'World.contacts_csv_write', ['self',
     'path']),
    ('dem_field_csv_write', ctypes.c_int, [ctypes.c_void_p, Field, ctypes.c_char_p], 'Field.csv_write', ['self',
     'self', 'path']),
    ('dem_outlet_residence_csv_write', ctypes.c_int, [ctypes.c_void_p, Outlet, ctypes.c_char_p],
     'Outlet.residence_csv_write', ['self', 'self', 'path']),
    ('dem_replay_open', ctypes.c_void_p, [ctypes.c_void_p, ctypes.c_char_p, ctypes.POINTER(ReplayDesc)],
     'World.replay', ['self', 'path', 'desc']),
    ('dem_replay_frame_write', ctypes.c_int, [ctypes.c_void_p], 'Replay.frame_write', ['self']),
    ('dem_replay_value_set', ctypes.c_int, [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_double], 'Replay.value_set',
     ['self', 'name', 'value']),
    ('dem_replay_close', ctypes.c_int, [ctypes.c_void_p], 'Replay.close', ['self']),
    ('dem_checkpoint_write', ctypes.c_int, [ctypes.c_void_p, ctypes.c_char_p], 'World.checkpoint_write', ['self',
     'path']),
    ('dem_checkpoint_read', ctypes.c_int, [ctypes.c_void_p, ctypes.c_char_p], 'World.checkpoint_read', ['self',
     'path']),
    ('dem_checkpoint_read_changed', ctypes.c_int, [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_char_p],
     'World.checkpoint_read_changed', ['self', 'path', 'allowed']),
    ('dem_checkpoint_changes_get', ctypes.c_char_p, [ctypes.c_void_p], 'World.checkpoint_changes', ['self']),
    ('dem_output_add', Output, [ctypes.c_void_p, ctypes.POINTER(OutputDesc)], 'World.output', ['self', 'desc']),
    ('dem_output_every_add', Output, [ctypes.c_void_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_double],
     'World.output_every', ['self', 'kind', 'path', 'interval']),
    ('dem_output_remove', ctypes.c_int, [ctypes.c_void_p, Output], 'Output.remove', ['self', 'self']),
    ('dem_slabs_create', ctypes.c_void_p, [ctypes.c_void_p, ctypes.POINTER(SlabsDesc)], 'World.slabs', ['self',
     'desc']),
    ('dem_slabs_destroy', None, [ctypes.c_void_p], 'Slabs.destroy', ['self']),
    ('dem_slabs_step', ctypes.c_int, [ctypes.c_void_p, ctypes.c_int], 'Slabs.step', ['self', 'steps']),
    ('dem_slabs_collect', ctypes.c_int, [ctypes.c_void_p, ctypes.c_void_p], 'Slabs.collect', ['self', 'world']),
    ('dem_slabs_loads_reset', None, [ctypes.c_void_p], 'Slabs.loads_reset', ['self']),
    ('dem_slabs_error_get', ctypes.c_char_p, [ctypes.c_void_p], 'Slabs.error', ['self']),
    ('dem_slab_get', ctypes.c_int, [ctypes.c_void_p, ctypes.c_int, ctypes.POINTER(Slab)], 'Slabs.slab', ['self',
     'index', 'slab']),
    ('dem_slabs_counters_get', SlabsCounters, [ctypes.c_void_p], 'Slabs.counters', ['self']),
    ('dem_effects_get', ctypes.c_int, [ctypes.c_void_p, ctypes.c_double, ctypes.POINTER(Effect)], 'World.effects',
     ['self', 'budget', 'effects']),
    ('dem_effects_print', None, [ctypes.c_void_p, ctypes.c_double, ctypes.c_void_p], 'World.effects_print', ['self',
     'budget', 'out']),
    ('dem_world_report', None, [ctypes.c_void_p, ctypes.c_void_p], 'World.report', ['self', 'out']),
    ('dempy_rows', ctypes.c_int, [ctypes.c_void_p, ctypes.c_size_t, ctypes.c_size_t, ctypes.c_int, ctypes.c_void_p], 'dempy_rows', ['self']*5),
    ('dempy_ids', ctypes.c_int, [ctypes.c_void_p, ctypes.c_int, ctypes.c_void_p], 'dempy_ids', ['self']*3),
    ('dempy_put', ctypes.c_int, [ctypes.c_void_p, ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p], 'dempy_put', ['self']*6),
]

for _name in [name for name in Bodies.kinds if name not in ("count", "real_count")]:
    setattr(Rows, _name, _row_property(_name, next(doc for name, _, doc in Bodies.rows if name == _name)))
_PARTS = {      # structs that properties return
    'Material': {'desc': MaterialDesc},
    'Wall': {'surface_velocity': Vec3, 'pose': Pose, 'loads': WallLoads, 'servo': Servo},
    'Field': {'data': FieldData},
    'Shape': {'info': ShapeInfo},
    'Body': {'state': BodyState, 'reaction': RailState, 'means': BodyMeans},
    'Joint': {'state': JointState},
    'Feed': {'state': FeedState},
    'Outlet': {'state': OutletState},
    'World': {'desc': WorldDesc, 'bodies_memory': Bodies, 'body_counts': BodyCounts, 'step_advice': Advice,
        'cell_state': CellState, 'counters': Counters, 'ledger': Ledger, 'totals': Totals, 'stress': Stress},
    'Slabs': {'counters': SlabsCounters},
}
_bind_all(globals())
__all__ = [_name for _name, _value in globals().items() if _name[0] != "_" and not isinstance(_value, types.ModuleType)
           and not hasattr(builtins, _name)]
