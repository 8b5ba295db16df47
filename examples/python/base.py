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
