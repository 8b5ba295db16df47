# ---- the shared library ------------------------------------------------------------------------

Real = ctypes.c_float if os.environ.get("DEM_REAL") == "float" else ctypes.c_double
_NAN = float("nan")
_SOURCE = """
#include <stddef.h>
#define DEM_IMPLEMENTATION
#include "dem.h"
"""


def _compiler(folder):
    """The command that compiles a shared library: the compiler and those flags that it accepts."""
    command = os.environ.get("CC", "cc").split() + os.environ.get("DEM_CFLAGS", "-O2").split()
    if not shutil.which(command[0]):
        raise ImportError("dem.py: the C compiler %r was not found, so dem.h cannot be compiled; install one (Debian "
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


def build(header=None, folder=None):
    """Compiles dem.h to a shared library, unless that has been done before, and returns its path.

    header: path of dem.h. Without it: the environment variable DEM_H, or dem.h in the folder of dem.py, two folders
    above, or in /usr/local/include. folder: where the library is kept. Without it: DEM_BUILD, or the folder build
    beside dem.h, or ~/.cache/dem if that cannot be written. The environment variables CC (cc) and DEM_CFLAGS (-O2)
    give the compiler and its flags; DEM_REAL=float compiles in single precision."""
    here = os.path.dirname(os.path.abspath(__file__))
    places = [header or os.environ.get("DEM_H")] if header or "DEM_H" in os.environ else [
        os.path.join(here, "dem.h"), os.path.join(here, "..", "..", "dem.h"), "/usr/local/include/dem.h"]
    header = next((os.path.abspath(place) for place in places if os.path.isfile(place)), None)
    if not header:
        raise ImportError("dem.py: dem.h was not found (%s); copy it beside dem.py, or set DEM_H" % ", ".join(places))
    folder = folder or os.environ.get("DEM_BUILD") or os.path.join(os.path.dirname(header), "build")
    try:
        os.makedirs(folder, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError:
        folder = os.path.join(os.path.expanduser("~"), ".cache", "dem")
        os.makedirs(folder, exist_ok=True)
    source = _SOURCE + _INLINE + "const size_t dempy_sizes[] = {%s, 0};\n" % ", ".join(
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
            file.write(source)
        command += ["-I" + os.path.dirname(header), os.path.join(work, "dem.c"), "-o", os.path.join(work, "dem.so"), "-lm"]
        if "-lomp" in command:
            command.append(command.pop(command.index("-lomp")))
        print("dem.py: compiling %s, once; this takes 10 to 30 s" % header, file=sys.stderr)
        result = subprocess.run(command, capture_output=True, text=True)
        if result.returncode:
            raise ImportError("dem.py: dem.h does not compile: %s\n%s" % (" ".join(command), result.stderr[-2000:]))
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
    name = path or build()
    library = ctypes.CDLL(name)
    for function, result, arguments in _FUNCTIONS:
        try:
            entry = getattr(library, function)
        except AttributeError:          # inline functions are in libraries that dem.build() has made
            if function.startswith("dempy_"):
                continue
            raise ImportError("dem.py: %s has no function %s; it is not a library of this dem.h" % (name, function)) from None
        entry.restype, entry.argtypes = result, arguments
        _lib.__dict__[function] = _checked(entry, function, arguments or [])
    if hasattr(library, "dempy_sizes"):
        sizes = (ctypes.c_size_t*(len(structs) + 1)).in_dll(library, "dempy_sizes")
        for size, kind in zip(sizes, structs):
            if size != ctypes.sizeof(kind):
                raise ImportError("dem.py: %s has %d bytes in dem.h and %d in dem.py; make dem.py again: python3 make.py"
                                  % (kind.c_name, size, ctypes.sizeof(kind)))
    world = library.dem_world_create_checked(WorldDesc(), VERSION, ctypes.sizeof(Real))
    if not world:
        raise ImportError("dem.py: %s is of another version than %d.%d.%d, or not in %s precision; build it from the "
                          "dem.h that belongs to dem.py" % (name, VERSION_MAJOR, VERSION_MINOR, VERSION_PATCH,
                                                            "single" if Real is ctypes.c_float else "double"))
    library.dem_world_destroy(world)
    _lib.__dict__["path"] = name


# ---- values: Python objects to C and back -------------------------------------------------------

class View:
    """The kind of a pointer to `kind`, with the names of the fields that hold the lengths of its axes."""

    def __init__(self, kind, *shape, const=False):
        self.kind, self.shape, self.const, self.c = kind, shape, const, ctypes.POINTER(kind)


class Text:
    """The kind of an array of characters."""

    def __init__(self, size):
        self.c = ctypes.c_char*size


class Choices:
    """The kind of an array of numbers of an enum."""

    def __init__(self, kind, size):
        self.kind, self.c = kind, ctypes.c_int*size


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


def _number(value, kind):
    """value as a number of an enum (which may be given by name) or of a C type. A text, a float in the place of a whole
    number and a bool in the place of a real raise TypeError; a number that does not fit raises OverflowError."""
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
            whole = operator.index(value)
        except TypeError:
            raise TypeError("%r is given, a whole number is needed" % (value,)) from None
        low, high = _LIMITS[ctypes.c_int if names else kind]
        if not low <= whole <= high:
            raise OverflowError("%d is given, must be from %d to %d" % (whole, low, high))
        return whole
    if kind in _NUMBERS:
        if type(value) is float and kind is ctypes.c_double:
            return value
        if isinstance(value, (str, bytes, bytearray, bool)) or not (hasattr(value, "__float__") or hasattr(value, "__index__")):
            raise TypeError("%r is given, a number is needed" % (value,))
        real = float(value)
        if kind is ctypes.c_float and math.isinf(kind(real).value) and not math.isinf(real):
            raise OverflowError("%r does not fit into single precision" % (value,))
        return real
    return value


def _checked(entry, name, kinds):
    """The function `entry`, with its numbers checked: ctypes would take them modulo 2**32."""
    places = [(i, kind, kind.make if isinstance(kind, type) and issubclass(kind, Struct) else None)
              for i, kind in enumerate(kinds) if kind in _NUMBERS or isinstance(kind, type) and issubclass(kind, Struct)]
    if not places:
        return entry

    def call(*values):
        values = list(values)
        for i, kind, make in places[:len(values)]:
            try:
                values[i] = make(values[i]) if make else _number(values[i], kind)
            except (TypeError, OverflowError) as error:
                raise type(error)("%s, argument %d: %s" % (name, i + 1, error)) from None
        return entry(*values)
    return call


def _c(kind):
    return ctypes.c_int if isinstance(kind, type) and issubclass(kind, enum.IntEnum) else getattr(kind, "c", kind)


def _convert(value, kind):
    """value as the kind of a field: sequences become structs, arrays and pointers to copies."""
    if isinstance(kind, View):
        if value is None or isinstance(value, (kind.c, ctypes._Pointer)):
            return value
        if issubclass(kind.kind, Struct) and isinstance(value, kind.kind):
            return ctypes.pointer(value)
        return ctypes.cast(_array(value, kind.kind), kind.c)
    if isinstance(kind, Text) or kind is str:
        if value is not None and not isinstance(value, (str, bytes, os.PathLike)):
            raise TypeError("%r is given, a text is needed" % (value,))
        return os.fsencode(value) if isinstance(value, os.PathLike) else value.encode() if isinstance(value, str) else value
    if isinstance(kind, type) and issubclass(kind, Struct):
        return kind.make(value)
    if isinstance(kind, Choices):
        return kind.c(*[_number(item, kind.kind) for item in value])
    if isinstance(kind, type) and issubclass(kind, ctypes.Array):
        if isinstance(value, kind):
            return value
        items = [_item(item, kind._type_) for item in (value if hasattr(value, "__len__") else (value,))]
        if len(items) > kind._length_:
            raise ValueError("%d values are given, at most %d are possible" % (len(items), kind._length_))
        return kind(*items)
    return _number(value, kind)


def _item(value, kind):
    """An element of an array: a struct, a pointer to one, or a number."""
    if issubclass(kind, Struct):
        return kind.make(value)
    if issubclass(kind, ctypes._Pointer):
        return kind() if value is None else ctypes.pointer(kind._type_.make(value))
    return _number(value, kind)


def _array(value, kind, count=None, name="an array"):
    """value as a C array of `kind`: the memory of a buffer of that kind itself, otherwise a copy. Nested sequences are
    flattened. count: the length that is required."""
    if value is None:
        return None
    if isinstance(value, ctypes.Array) and value._type_ is kind:
        array = value
    else:
        array = None
        if not issubclass(kind, Struct):
            try:
                view = memoryview(value)
                if view.c_contiguous and not view.readonly and view.format.lstrip("<@=") == kind._type_:
                    array = (kind*(view.nbytes//ctypes.sizeof(kind))).from_buffer(view.cast("B"))
            except (TypeError, ValueError):
                pass
        if array is None:
            items = list(_flat(value, kind))
            array = (kind*len(items))(*items)
    if count is not None and len(array) != count:
        raise ValueError("%s has %d numbers instead of %d" % (name, len(array), count))
    return array


def _flat(value, kind):
    if hasattr(value, "tolist"):
        value = value.tolist()
    for item in value:
        if isinstance(item, Struct) and not isinstance(item, kind):
            yield from _flat(item, kind)
        elif hasattr(item, "__len__") and not isinstance(item, kind):
            yield from _flat(item, kind)
        else:
            yield kind.make(item) if issubclass(kind, Struct) else _number(item, kind)


def _count(array, width, name):
    """The number of rows of an array of rows of `width`."""
    if array is None:
        return 0
    if len(array) % width:
        raise ValueError("%s has %d numbers, which is no multiple of %d" % (name, len(array), width))
    return len(array)//width


def _view(pointer, kind, shape, owner, const):
    """The memory behind a pointer as a memoryview of this shape (of structs: as a C array); None for null."""
    if not pointer:
        return None
    count = 1
    for length in shape:
        count *= length
    array = (kind*count).from_address(ctypes.addressof(pointer.contents)) if count else (kind*0)()
    array.owner = owner                                     # the world lives as long as the view
    if issubclass(kind, Struct):
        return array
    view = memoryview(array).cast("B").cast(array._type_._type_, *([list(shape)] if count else []))
    return view.toreadonly() if const else view


def _functions(struct):
    """The Python functions of a struct, by their path in it; none of a struct that C has made."""
    return getattr(struct, "_functions", None) or {}


class Struct(ctypes.Structure):
    """A struct of dem.h. Fields are keyword arguments; fields that are not given are 0."""
    __slots__ = ("_functions", "_of", "_extra")
    rows, c_name, counts, kinds = [], "", {}, {}

    def __init__(self, *values, **fields):
        super().__init__()
        self._functions, self._of, self._extra = {}, None, None
        if len(values) > len(self.rows):
            raise TypeError("%s has %d fields; %d values are given" % (type(self).__name__, len(self.rows), len(values)))
        if values or fields:
            self._put(dict(zip(self.kinds, values), **fields))

    def _put(self, fields):
        for name, value in fields.items():
            if name not in self.kinds:
                raise TypeError("%s has no field %r; it has %s" % (type(self).__name__, name, ", ".join(self.kinds)))
            if name == "cylinder" and value in ("x", "y", "z"):
                value = ord(value)                          # dem.h has the axis as a character
            try:
                ctypes.Structure.__setattr__(self, name, _convert(value, self.kinds[name]))
            except (TypeError, ValueError, OverflowError) as error:
                raise type(error)("%s.%s: %s" % (type(self).__name__, name, error)) from None
            for path, item in [((name,), value)] if isinstance(value, Struct) else [
                    ((name, i), item) for i, item in enumerate(value) if isinstance(item, Struct)] if isinstance(value, (list, tuple)) else []:
                for inner, function in _functions(item).items():        # C copies structs without their Python functions
                    self._functions[path + inner] = function
        for name, (field, width) in self.counts.items():    # a length follows from its array, unless it is given
            if field in fields and fields[field] is not None:
                given = fields[field]
                if isinstance(given, ctypes._Pointer):      # nobody knows its length
                    continue
                size = len(_array(given, self.kinds[field].kind)) if isinstance(self.kinds[field], View) else len(
                    given) if hasattr(given, "__len__") else 1
                if fields.get(name) and fields[name]*width > size:
                    raise ValueError("%s.%s is %d, but %s has %d numbers" % (type(self).__name__, name, fields[name], field, size))
                if not fields.get(name):
                    setattr(self, name, size//width)

    def __setattr__(self, name, value):
        kind = type(self).kinds.get(name)
        if kind in _NUMBERS:
            try:
                value = _number(value, kind)
            except (TypeError, OverflowError) as error:
                raise type(error)("%s.%s: %s" % (type(self).__name__, name, error)) from None
        super().__setattr__(name, value)

    @classmethod
    def make(cls, value):
        """This struct from an instance, a sequence, a dict, or None (zeros)."""
        if isinstance(value, cls):
            return value
        if value is None:
            return cls()
        if isinstance(value, dict):
            return cls(**value)
        first = cls.rows[0][1]
        if isinstance(value, Struct):
            return cls(value)
        value = tuple(value)
        if isinstance(first, type) and issubclass(first, Struct) and len(value) == ctypes.sizeof(cls)//ctypes.sizeof(Real):
            size = ctypes.sizeof(first)//ctypes.sizeof(Real)
            return cls(*[value[i:i + size] for i in range(0, len(value), size)])     # a box from six numbers
        if len(value) != len(cls.rows) and isinstance(first, type) and issubclass(first, Struct):
            return cls(value)
        return cls(*value)

    @classmethod
    def from_param(cls, value):
        return cls.make(value)

    def __iter__(self):
        return (getattr(self, name) for name in self.kinds)

    def __len__(self):
        return len(self.rows)

    def __getitem__(self, index):
        return tuple(self)[index]

    def __eq__(self, other):
        return tuple(self) == tuple(other) if isinstance(other, (Struct, tuple, list)) else NotImplemented

    __hash__ = None

    def __repr__(self):
        shown = []
        for name in self.kinds:
            value = getattr(self, name)
            if isinstance(value, memoryview):
                value = "<%s>" % " x ".join(map(str, value.shape))
            elif isinstance(value, ctypes.Array):
                value = list(value)
            if value or not hasattr(value, "__len__"):
                shown.append("%s=%r" % (name, value))
        return "%s(%s)" % (type(self).__name__, ", ".join(shown))


def _field(name, kind, doc):
    """A property for a field whose C value is not what Python users expect."""
    raw = "_" + name

    def get(self):
        value = getattr(self, raw)
        if isinstance(kind, Function):
            return _functions(self).get((name,)) or (value if value else None)
        if isinstance(kind, View):
            shape = []
            for axis in kind.shape:
                length = getattr(self, axis) if isinstance(axis, str) else axis
                if isinstance(length, ctypes.Array):        # cells along three axes
                    length = length[0]*length[1]*length[2]
                shape.append(length)
            return _view(value, kind.kind, shape, self, kind.const) if shape else value
        if isinstance(kind, Choices):
            return tuple(kind.kind(item) for item in value)
        if isinstance(kind, Text):
            return value.decode(errors="replace")
        if kind is str:
            return None if value is None else value.decode(errors="replace")
        try:
            return kind(value)
        except ValueError:
            return value

    def put(self, value):
        if isinstance(kind, Function):
            if not hasattr(self, "_functions"):
                raise TypeError("%s.%s: this struct is a part of another; make it with its function, then assign it" % (
                    type(self).__name__, name))
            self._functions.pop((name,), None)
            if value is None:
                setattr(self, raw, kind.c())
            elif isinstance(value, ctypes._CFuncPtr):       # a function compiled in C
                setattr(self, raw, ctypes.cast(value, kind.c))
            elif callable(value):
                self._functions[name,] = value
            else:
                raise TypeError("%s.%s: %r is no function" % (type(self).__name__, name, value))
        else:
            setattr(self, raw, _convert(value, kind))
    return property(get, put, doc=doc)


def _struct(cls):
    """Gives a subclass of Struct the fields of its rows."""
    fields, docs = [], []
    cls._functions_ = {}
    for name, kind, doc in cls.rows:
        special = isinstance(kind, (View, Text, Function, Choices)) or kind is str or issubclass(kind, enum.IntEnum)
        c = ctypes.c_char_p if kind is str else _c(kind)
        fields.append(("_" + name if special else name, c))
        if isinstance(kind, Function):
            cls._functions_[name] = kind
        if special:
            setattr(cls, name, _field(name, kind, doc))
        if doc:
            docs.append("%s: %s" % (name, doc))
    cls.kinds = {name: kind for name, kind, _ in cls.rows}
    cls._fields_ = fields
    if docs:
        cls.__doc__ = (cls.__doc__ or "") + "\n\n" + "\n".join(docs)
    return cls


class Id(Struct):
    """The id of an object of a world. Two ids are equal if they name the same object."""
    __slots__ = ()

    def of(self, world):
        """The same id, as a part of another world: of a copy that a function of yours sees, or of a checkpoint."""
        copy = type(self).from_buffer_copy(self)
        copy._functions, copy._of, copy._extra = {}, world, None
        return copy

    @property
    def world(self):
        if getattr(self, "_of", None) is None:
            raise ValueError("this id belongs to no world yet; write id.of(world)")
        return self._of

    def __bool__(self):
        return any(bytes(self))

    def __eq__(self, other):
        return type(self) is type(other) and bytes(self) == bytes(other)

    def __hash__(self):
        return hash((type(self), bytes(self)))


# ---- errors -------------------------------------------------------------------------------------

class Error(Exception):
    """A call of dem.h has failed. The text is the error message of dem.h: the function, what is wrong with the value,
    the limit, the likely cause, the remedy. result: the dem.Result."""
    result = None


class _Context:
    """What the functions that a world calls share: the first exception, and the world."""

    def __init__(self, world):
        self.raised, self.kept, self.go_on, self.memory, self.reals = None, {}, None, 0, 0
        self.world_of = weakref.ref(world)

    def fail(self, error):
        if self.raised is None:
            self.raised = error

    def world(self, pointer):
        world = self.world_of()
        return world if world is not None and world._at == pointer else World._borrow(pointer, self)


class Handle:
    """A world, a replay or slabs: memory that the library owns."""
    _at = _context = None

    def _text(self):
        return ""

    def _raise(self, kind):
        raise kind(self._text() or "no message")

    def _ok(self, result):
        """Raises the exception of a function of yours, or that of a result other than OK."""
        if self._context and self._context.raised is not None:
            error, self._context.raised = self._context.raised, None
            if result and hasattr(error, "add_note"):
                error.add_note("dem.h: " + self._text())
            raise error
        if result:
            self._raise(_ERRORS[result])

    def _run(self, function, *arguments):
        """Calls a function that takes long. Ctrl-C meanwhile is noted: a progress function then ends the run, and the
        caller gets KeyboardInterrupt."""
        before = _signal.getsignal(_signal.SIGINT) if threading.get_ident() == threading.main_thread().ident else None
        if not callable(before):
            return function(*arguments)

        def note(number, frame):
            try:
                before(number, frame)
            except BaseException as error:
                self._context.fail(error)
        _signal.signal(_signal.SIGINT, note)
        try:
            return function(*arguments)
        finally:
            _signal.signal(_signal.SIGINT, before)

    def _id(self, value):
        self._ok(0)
        if not value:
            self._raise(Error)
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
                warnings.warn(text, stacklevel=3)
        return added

    def _bound(self, struct, key=None):
        """A struct whose Python functions have become C functions, which live as long as the world."""
        if not _functions(struct):
            return struct
        copy = type(struct).from_buffer_copy(struct)
        copy._functions, copy._of, copy._extra = {}, None, struct
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

    def _callback(self, kind, function):
        """A C function of a Python function, for one call."""
        if function is None:
            return kind.c()
        if function is _go_on:
            if not self._context.go_on:
                self._context.go_on = kind.wrap(_go_on, self._context, None)
            return self._context.go_on
        if isinstance(function, ctypes._CFuncPtr):
            return ctypes.cast(function, kind.c)
        return kind.wrap(function, self._context, None)

    def _with(self, struct):
        """Ties a struct that the library has filled to the world, whose memory its views keep alive."""
        struct._of, struct._extra = self, self._memory
        return struct

    def _print(self, function, out, *arguments):
        """Calls a function that prints to a FILE, and prints its text to `out` (sys.stdout)."""
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
        print(text.raw[:size].decode(errors="replace"), end="", file=out or sys.stdout)
        self._ok(0)
        return result

    def _taken(self, struct, free):
        """A copy of a struct in memory of Python; frees the memory of the library."""
        copy = type(struct).from_buffer_copy(struct)
        copy._functions, copy._of, copy._extra = {}, None, []
        for name, kind in struct.kinds.items():
            pointer = getattr(struct, "_" + name) if isinstance(kind, View) else None
            if pointer:
                view = getattr(struct, name)
                array = (kind.kind*(view.nbytes//ctypes.sizeof(kind.kind))).from_buffer_copy(view.cast("B"))
                copy._extra.append(array)
                setattr(copy, "_" + name, ctypes.cast(array, kind.c))
        free(self._at, struct)
        return copy

    def __reduce_ex__(self, _):
        raise TypeError("a %s owns memory of dem.h and cannot be copied; write and read a checkpoint" % type(self).__name__)

    def close(self):
        """Ends it and frees its memory; further calls raise an error. Leaving a `with` block does the same."""
        if self._at is not None:
            self._free()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __del__(self):
        try:
            self.close()
        except Exception:
            pass


class _Film:
    """An open replay of the library; at: None when it is closed."""

    def __init__(self, at):
        self.at = at


class _Memory:
    """A world of the library, with its open replays. When neither the World nor a view of its arrays is left, completes
    the replays and destroys the world. The garbage collector ends the objects of a cycle in any order, so a World and a
    Replay read here whether they are open."""

    def __init__(self, at, context):
        self.at, self.context, self.films = at, context, set()

    def complete(self, film):
        at, film.at = film.at, None
        self.films.discard(film)
        return _lib.dem_replay_close(at)

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

    def _create(self, desc):
        self._context = _Context(self)
        functions = {path[0] for path in desc._functions}
        if functions & {"law", "law_rate", "force", "body_force", "body_reals_fn"} and not desc.threads:
            desc.threads = 1                        # Python runs one function at a time
        if "force" in functions:                    # ctypes has no functions that return a struct
            force, whole = desc._functions.pop(("force",)), desc._functions.get(("body_force",))

            def both(body, id, time, sum, torque):
                sum.x, sum.y, sum.z = force(body.position, body.velocity, body.radius, body.mass, time)
                if whole:
                    whole(body, id, time, sum, torque)
            desc._functions["body_force",] = both
        self._context.memory, self._context.reals = desc.law_memory, len((desc.body_reals or "").split())
        bound = self._bound(desc, "desc")
        at = _lib.dem_world_create_checked(bound, VERSION, ctypes.sizeof(Real))
        if not at:
            raise ArgumentError((_lib.dem_world_create_error_get(bound) or b"").decode())
        self._memory = _Memory(at, self._context)

    @classmethod
    def _borrow(cls, pointer, context):
        """A world that belongs to the library: a copy that a function of yours sees."""
        world = cls.__new__(cls)
        world._context, world._memory = context, types.SimpleNamespace(at=pointer, films=())
        return world

    def _text(self):
        return (_lib.dem_world_error_get(self._at) or b"").decode(errors="replace")

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
        self._film, self._world, self._context, self._memory, self.path = _Film(at), world, world._context, world._memory, path
        self._memory.films.add(self._film)

    @property
    def _at(self):
        return self._film.at

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
    """Prints the progress of a run to sys.stderr, a line for every tenth of the run: world.run(1, dem.progress_print)."""
    world._print(_lib.dem_progress_print, sys.stderr, world._at, done, seconds_left)


def _go_on(world, done, seconds_left):
    """The progress function of runs that are given none: lets Python handle Ctrl-C."""


def tail(memory, first):
    """The numbers of a contact history from number `first` on, for built-in laws that follow another one."""
    part = (Real*(len(memory) - first)).from_address(ctypes.addressof(memory) + first*ctypes.sizeof(Real))
    part.owner = memory
    return part


class Page:
    """A replay file, which Jupyter shows inside a notebook: dem.Page("drum.html")."""

    def __init__(self, path, height=560):
        self.path, self.height = path, height

    def _repr_html_(self):
        with open(self.path, encoding="utf-8") as file:
            return '<iframe srcdoc="%s" width="100%%" height="%d" style="border:0"></iframe>' % (
                html.escape(file.read()), self.height)
