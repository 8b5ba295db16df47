# Types of dem.py for editors and type checkers. make.py made this file from dem.h: `make python`.
import builtins
import ctypes
import enum
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, TextIO

_Numbers = Sequence[Any]        # as many as fields, such as (0, 0, 1)
_Array = Any                    # lists, nested or flat, buffers, arrays of numpy, tables of pandas
Real: type

def build(header: str | None = ..., folder: str | None = ...) -> str: ...
def load(path: str | None = ...) -> None: ...
def compile(source: str | os.PathLike[str], flags: str | Sequence[str] = ...) -> ctypes.CDLL: ...
def tail(memory: Any, first: int) -> Any: ...
def progress_print(world: World, done: float, seconds_left: float) -> None: ...

class Struct(ctypes.Structure):
    def __iter__(self) -> Iterator[Any]: ...
    def __len__(self) -> int: ...
    def __getitem__(self, index: Any) -> Any: ...
    def __setitem__(self, index: Any, value: Any) -> None: ...
    def keys(self) -> list[str]: ...
    def to_dict(self) -> dict[str, Any]: ...
    @classmethod
    def make(cls, value: Any) -> Any: ...

class Numbers(Struct):
    def __array__(self, dtype: Any = ..., copy: Any = ...) -> Any: ...
    def __add__(self, other: Any) -> Any: ...
    def __radd__(self, other: Any) -> Any: ...
    def __sub__(self, other: Any) -> Any: ...
    def __rsub__(self, other: Any) -> Any: ...
    def __mul__(self, other: Any) -> Any: ...
    def __rmul__(self, other: Any) -> Any: ...
    def __truediv__(self, other: Any) -> Any: ...
    def __iadd__(self, other: Any) -> Any: ...
    def __isub__(self, other: Any) -> Any: ...
    def __imul__(self, other: Any) -> Any: ...
    def __itruediv__(self, other: Any) -> Any: ...
    def __neg__(self) -> Any: ...
    def __abs__(self) -> float: ...
    def dot(self, other: Any) -> float: ...

class Vector(Numbers):
    def cross(self, other: Any) -> Any: ...

class Id(Struct):
    def of(self, world: World) -> Any: ...
    @property
    def world(self) -> World: ...

class Handle:
    def close(self) -> None: ...
    def __enter__(self) -> Any: ...
    def __exit__(self, *_: Any) -> None: ...

class WorldBase(Handle):
    gravity: Any
    dt: float
    @property
    def bodies(self) -> Rows: ...
    def __len__(self) -> int: ...

class ReplayBase(Handle):
    @property
    def path(self) -> str: ...

class SlabsBase(Handle): ...

class Structs:
    def __len__(self) -> int: ...
    def __getitem__(self, index: Any) -> Any: ...
    def __array__(self, dtype: Any = ..., copy: Any = ...) -> Any: ...
    def to_dict(self) -> dict[str, list[Any]]: ...

class Array:
    view: memoryview
    @property
    def shape(self) -> tuple[int, ...]: ...
    ndim: int
    nbytes: int
    itemsize: int
    readonly: bool
    format: str
    def __init__(self, view: Any) -> None: ...
    def __len__(self) -> int: ...
    def __getitem__(self, index: Any) -> Any: ...
    def __setitem__(self, index: Any, value: Any) -> None: ...
    def __iter__(self) -> Iterator[Any]: ...
    def __array__(self, dtype: Any = ..., copy: Any = ...) -> Any: ...
    def tolist(self) -> list[Any]: ...
    def tobytes(self) -> bytes: ...

class Row(ctypes.Array[Any]):
    def __add__(self, other: Any) -> Any: ...
    def __radd__(self, other: Any) -> Any: ...
    def __sub__(self, other: Any) -> Any: ...
    def __rsub__(self, other: Any) -> Any: ...
    def __mul__(self, other: Any) -> Any: ...
    def __rmul__(self, other: Any) -> Any: ...
    def __truediv__(self, other: Any) -> Any: ...
    def __iadd__(self, other: Any) -> Any: ...
    def __isub__(self, other: Any) -> Any: ...
    def __imul__(self, other: Any) -> Any: ...
    def __itruediv__(self, other: Any) -> Any: ...

class Page:
    def __init__(self, path: str | os.PathLike[str], height: int = ...) -> None: ...

class Rows:
    count: int
    real_count: int
    positions: Any
    velocities: Any
    spins: Any
    forces: Any
    torques: Any
    masses: Any
    slots: Any
    materials: Any
    orientations: Any
    shapes: Any
    reals: Any
    rates: Any
    groups: Any
    def __len__(self) -> int: ...
    def __getitem__(self, index: Any) -> Any: ...
    def __iter__(self) -> Iterator[Body]: ...
    def to_dict(self) -> dict[str, list[Any]]: ...

VERSION_MAJOR: int
VERSION_MINOR: int
VERSION_PATCH: int
GROUPS: int
BODY_REALS: int
LAW_MEMORY: int
SIEVES: int
POLYHEDRON_FACES: int
RINGS: int
RAIL_X: int
RAIL_Y: int
RAIL_Z: int
RAIL_SPIN_X: int
RAIL_SPIN_Y: int
RAIL_SPIN_Z: int
RAIL_ALL: int
CLASSES: int
RESIDENCE_BINS: int
OBSERVABLES: int
TRIALS: int
IMPACT_BINS: int
IMPACT_LIMITS: int
REPLAY_VALUES: int
OUTPUT_COLUMNS: int
EFFECTS: int
VERSION: int
__version__: str

class Result(enum.IntEnum):
    OK = 0
    ERROR_ARGUMENT = 1
    ERROR_MEMORY = 2
    ERROR_FILE = 3
    ERROR_FORMAT = 4
    ERROR_TIME_STEP = 5
    ERROR_UNSTABLE = 6
    ERROR_STOPPED = 7

class NormalLaw(enum.IntEnum):
    HERTZ = 0
    LINEAR = 1
    HYSTERETIC = 2

class TangentLaw(enum.IntEnum):
    AUTO = 0
    NONE = 1
    VISCOUS = 2
    STEP = 3
    SPRING = 4
    MINDLIN = 5
    MINDLIN_RESCALED = 6

class RollingLaw(enum.IntEnum):
    AUTO = 0
    NONE = 1
    STEP = 2
    CONSTANT = 3
    EPSD = 4

class Tension(enum.IntEnum):
    ALLOWED = 0
    CLIPPED = 1
    COMPENSATED = 2

class Load(enum.IntEnum):
    REPULSIVE = 0
    ELASTIC = 1
    MAGNITUDE = 2

class Slider(enum.IntEnum):
    PARALLEL = 0
    SPRING = 1
    REMAINDER = 2

class Convention(enum.IntEnum):
    STANDARD = 0
    MILL = 1

class Integrator(enum.IntEnum):
    VELOCITY_VERLET = 0
    FORWARD_EULER = 1
    SYMPLECTIC_EULER = 2
    POSITION_VERLET = 3
    LEAPFROG = 4

class Response(enum.IntEnum):
    SPRINGS = 0
    IMPULSES = 1

class Cone(enum.IntEnum):
    COULOMB = 0
    CONVEX = 1

class Solver(enum.IntEnum):
    GAUSS_SEIDEL = 0
    JACOBI = 1
    APGD = 2
    SPECTRAL = 3

class Rotation(enum.IntEnum):
    SPIRAL = 0
    FINCHAM = 1
    NO_SQUISH = 2

class Overlap(enum.IntEnum):
    CONSERVATIVE = 0
    CHORD = 1
    NORMAL = 2

class ClusterContacts(enum.IntEnum):
    MERGED = 0
    SEPARATE = 1

class Search(enum.IntEnum):
    AUTO = 0
    ALL_PAIRS = 1
    GRID = 2
    LINKED_LIST = 3
    HIERARCHICAL = 4
    BINS = 5

class Boundary(enum.IntEnum):
    OPEN = 0
    PERIODIC = 1
    OUTFLOW = 2

class SizesKind(enum.IntEnum):
    UNIFORM = 0
    LOGNORMAL = 1
    WEIBULL = 2
    SIEVE_CURVE = 3
    NORMAL = 4
    EXPONENTIAL = 5

class ClusterMass(enum.IntEnum):
    UNION = 0
    SUM = 1
    GIVEN = 2

class MotionKind(enum.IntEnum):
    FIXED = 0
    TRANSLATING = 1
    ROTATING = 2
    OSCILLATING = 3
    USER = 4
    TABLE = 5
    SERVO = 6

class EdgeRule(enum.IntEnum):
    RESOLVED = 0
    FRACTION = 1

class SieveKind(enum.IntEnum):
    NONE = 0
    WIRES = 1
    BARS = 2
    SQUARE = 3
    ROUND = 4
    SLOTS = 5
    REDUCED = 6

class JointKind(enum.IntEnum):
    NONE = 0
    POINT = 1
    REVOLUTE = 2

class Motor(enum.IntEnum):
    NONE = 0
    SPEED = 1
    TORQUE = 2

class Severity(enum.IntEnum):
    NOTE = 1
    WARNING = 2
    ERROR = 3

class EventKind(enum.IntEnum):
    END = 0
    BEGIN = 1
    OPEN = 2

class OutputKind(enum.IntEnum):
    CALL = 0
    VTP = 1
    XYZ = 2
    CONTACTS = 3
    CHECKPOINT = 4
    CSV = 5
    SURFACES = 6
    WALLS = 7
    BODIES_CSV = 8
    CONTACTS_CSV = 9
    FIELD_CSV = 10

class EffectState(enum.IntEnum):
    OFF = 0
    IDLE = 1
    ACTIVE = 2

class Error(Exception):
    result: Result | None

class ArgumentError(Error, builtins.ValueError): ...
class MemoryError(Error, builtins.MemoryError): ...
class FileError(Error, builtins.OSError): ...
class FormatError(Error, builtins.ValueError): ...
class TimeStepError(Error): ...
class UnstableError(Error): ...
class StoppedError(Error): ...
class ArgumentTypeError(Error, builtins.TypeError): ...
class ArgumentRangeError(Error, builtins.OverflowError): ...
class FieldError(Error, builtins.AttributeError): ...
class LoadError(Error, builtins.ImportError): ...
class NoSuchError(ArgumentError, builtins.IndexError): ...
class NoFieldError(ArgumentError, builtins.AttributeError): ...

class Vec3(Vector):
    x: float
    y: float
    z: float
    def __init__(self, x: float = ..., y: float = ..., z: float = ...) -> None: ...

class Box(Struct):
    lo: Vec3
    hi: Vec3
    def __init__(self, lo: Vec3 | _Numbers | None = ..., hi: Vec3 | _Numbers | None = ...) -> None: ...

class Quat(Numbers):
    w: float
    x: float
    y: float
    z: float
    def __init__(self, w: float = ..., x: float = ..., y: float = ..., z: float = ...) -> None: ...

class Pose(Struct):
    position: Vec3
    rotation: Any
    velocity: Vec3
    spin: Vec3
    def __init__(self, *values: Any, position: Vec3 | _Numbers | None = ..., rotation: _Array | None = ..., velocity: Vec3 | _Numbers | None = ..., spin: Vec3 | _Numbers | None = ...) -> None: ...

class Material(Id):
    id: int
    def __init__(self, id: int = ...) -> None: ...
    def set(self, *, density: float = ..., young: float = ..., poisson: float = ..., restitution: float = ..., friction: float = ..., friction_static: float = ..., rolling_friction: float = ..., stiffness: float = ..., stiffness_ratio: float = ..., stiffness_unloading: float = ..., stiffness_adhesion: float = ...) -> None: ...
    @property
    def desc(self) -> MaterialDesc: ...

class Wall(Id):
    id: int
    def __init__(self, id: int = ...) -> None: ...
    @property
    def reals(self) -> ctypes.Array[Any]: ...
    def reals_set(self, reals: _Array) -> None: ...
    def motion_set(self, *, kind: MotionKind | str | int = ..., velocity: Vec3 | _Numbers | None = ..., point: Vec3 | _Numbers | None = ..., axis: Vec3 | _Numbers | None = ..., speed: float = ..., amplitude: float = ..., frequency: float = ..., phase: float = ..., start: float = ..., function: Callable[..., Any] | None = ..., user: Any = ..., ramp: float = ..., load: float = ..., area: float = ..., travel: float = ..., table: Sequence[MotionRow | Mapping[str, Any]] | None = ..., table_count: int = ..., table_repeats: int = ...) -> None: ...
    def surface_velocity_set(self, velocity: Vec3 | _Numbers) -> None: ...
    @property
    def surface_velocity(self) -> Vec3: ...
    @property
    def pose(self) -> Pose: ...
    def remove(self) -> None: ...
    @property
    def loads(self) -> WallLoads: ...
    def loads_reset(self) -> None: ...
    def wear(self, coefficient: float, hardness: float) -> Wear: ...
    @property
    def wear_facets(self) -> list[float]: ...
    @property
    def servo(self) -> Servo: ...
    def loads_csv_write(self, path: str | os.PathLike[str]) -> None: ...

class Field(Id):
    id: int
    def __init__(self, id: int = ...) -> None: ...
    @property
    def data(self) -> FieldData: ...
    def cell(self, i: int, j: int, k: int) -> FieldCell: ...
    def reset(self) -> None: ...
    def csv_write(self, path: str | os.PathLike[str]) -> None: ...

class Group(Id):
    id: int
    def __init__(self, id: int = ...) -> None: ...

class Shape(Id):
    id: int
    def __init__(self, id: int = ...) -> None: ...
    @property
    def info(self) -> ShapeInfo: ...

class Body(Id):
    slot: int
    generation: int
    def __init__(self, slot: int = ..., generation: int = ...) -> None: ...
    def remove(self) -> None: ...
    @property
    def state(self) -> BodyState: ...
    def set(self, *, position: Vec3 | _Numbers | None = ..., velocity: Vec3 | _Numbers | None = ..., spin: Vec3 | _Numbers | None = ..., fixed: int = ..., orientation: Quat | _Numbers | None = ...) -> None: ...
    def radius_set(self, radius: float) -> None: ...
    @property
    def reals(self) -> ctypes.Array[Any]: ...
    def reals_set(self, reals: _Array) -> None: ...
    def rail_set(self, *, axes: int = ..., velocity: Vec3 | _Numbers | None = ..., spin: Vec3 | _Numbers | None = ..., wall: Wall | None = ...) -> None: ...
    @property
    def reaction(self) -> RailState: ...
    @property
    def means(self) -> BodyMeans: ...

class ContactWho(Struct):
    a: Body
    b: Body
    radius_a: float
    radius_b: float
    mass_a: float
    mass_b: float
    point: Vec3
    time: float
    reals_a: Any
    reals_b: Any
    rate_a: Any
    rate_b: Any
    def __init__(self, *values: Any, a: Body | None = ..., b: Body | None = ..., radius_a: float = ..., radius_b: float = ..., mass_a: float = ..., mass_b: float = ..., point: Vec3 | _Numbers | None = ..., time: float = ..., reals_a: _Array | None = ..., reals_b: _Array | None = ..., rate_a: _Array | None = ..., rate_b: _Array | None = ...) -> None: ...

class Contact(Struct):
    overlap: float
    range: float
    closing_speed: float
    normal: Vec3
    slip: Vec3
    spin: Vec3
    slip_step: Vec3
    spin_step: Vec3
    normal_rate: Vec3
    twist: float
    r_eff: float
    m_eff: float
    dt: float
    kn: float
    cn: float
    kt: float
    ct: float
    kun: float
    friction: float
    friction_static: float
    rolling_friction: float
    spinning_friction: float
    sliding: float
    material_a: int
    material_b: int
    wall: int
    tension: int
    friction_load: int
    slider: int
    who: ContactWho
    user: Any
    kad: float
    def __init__(self, *values: Any, overlap: float = ..., range: float = ..., closing_speed: float = ..., normal: Vec3 | _Numbers | None = ..., slip: Vec3 | _Numbers | None = ..., spin: Vec3 | _Numbers | None = ..., slip_step: Vec3 | _Numbers | None = ..., spin_step: Vec3 | _Numbers | None = ..., normal_rate: Vec3 | _Numbers | None = ..., twist: float = ..., r_eff: float = ..., m_eff: float = ..., dt: float = ..., kn: float = ..., cn: float = ..., kt: float = ..., ct: float = ..., kun: float = ..., friction: float = ..., friction_static: float = ..., rolling_friction: float = ..., spinning_friction: float = ..., sliding: float = ..., material_a: int = ..., material_b: int = ..., wall: int = ..., tension: int = ..., friction_load: int = ..., slider: int = ..., who: ContactWho | Mapping[str, Any] | None = ..., user: Any = ..., kad: float = ...) -> None: ...

class ContactEnergy(Struct):
    dashpot: float
    sag: float
    elastic: float
    shear_work: float
    slide: float
    shear_stored: float
    roll: float
    def __init__(self, *values: Any, dashpot: float = ..., sag: float = ..., elastic: float = ..., shear_work: float = ..., slide: float = ..., shear_stored: float = ..., roll: float = ...) -> None: ...

class ContactForce(Struct):
    normal: float
    tangent: Vec3
    moment: Vec3
    elastic: float
    load: float
    slope: float
    slope_step: float
    kt: float
    kt_step: float
    ct: float
    sliding: float
    energy: ContactEnergy
    def __init__(self, *values: Any, normal: float = ..., tangent: Vec3 | _Numbers | None = ..., moment: Vec3 | _Numbers | None = ..., elastic: float = ..., load: float = ..., slope: float = ..., slope_step: float = ..., kt: float = ..., kt_step: float = ..., ct: float = ..., sliding: float = ..., energy: ContactEnergy | Mapping[str, Any] | None = ...) -> None: ...

class Allocator(Struct):
    alloc_fn: Callable[..., Any] | None
    free_fn: Callable[..., Any] | None
    user: Any
    def __init__(self, *values: Any, alloc_fn: Callable[..., Any] | None = ..., free_fn: Callable[..., Any] | None = ..., user: Any = ...) -> None: ...

class ContactRows(Struct):
    count: int
    memory_count: int
    touch: Any
    overlap: Any
    range: Any
    closing_speed: Any
    twist: Any
    sliding: Any
    normal: Any
    slip: Any
    spin: Any
    slip_step: Any
    spin_step: Any
    normal_rate: Any
    r_eff: Any
    m_eff: Any
    kn: Any
    cn: Any
    kt: Any
    ct: Any
    kun: Any
    friction: Any
    friction_static: Any
    rolling_friction: Any
    spinning_friction: Any
    material_a: Any
    material_b: Any
    kad: Any
    dt: float
    tension: int
    friction_load: int
    slider: int
    user: Any
    memory: Any
    normal_force: Any
    tangent: Any
    moment: Any
    slides: Any
    energy: Any
    def __init__(self, *values: Any, count: int = ..., memory_count: int = ..., touch: _Array | None = ..., overlap: _Array | None = ..., range: _Array | None = ..., closing_speed: _Array | None = ..., twist: _Array | None = ..., sliding: _Array | None = ..., normal: _Array | None = ..., slip: _Array | None = ..., spin: _Array | None = ..., slip_step: _Array | None = ..., spin_step: _Array | None = ..., normal_rate: _Array | None = ..., r_eff: _Array | None = ..., m_eff: _Array | None = ..., kn: _Array | None = ..., cn: _Array | None = ..., kt: _Array | None = ..., ct: _Array | None = ..., kun: _Array | None = ..., friction: _Array | None = ..., friction_static: _Array | None = ..., rolling_friction: _Array | None = ..., spinning_friction: _Array | None = ..., material_a: _Array | None = ..., material_b: _Array | None = ..., kad: _Array | None = ..., dt: float = ..., tension: int = ..., friction_load: int = ..., slider: int = ..., user: Any = ..., memory: _Array | None = ..., normal_force: _Array | None = ..., tangent: _Array | None = ..., moment: _Array | None = ..., slides: _Array | None = ..., energy: _Array | None = ...) -> None: ...

class WorldDesc(Struct):
    gravity: Vec3
    domain: Box
    boundary: Sequence[Boundary | str | int]
    planar: int
    thickness: float
    normal_law: NormalLaw
    tangent_law: TangentLaw
    rolling_law: RollingLaw
    tension: Tension
    friction_load: Load
    slider: Slider
    convention: Convention
    law: Callable[..., Any] | None
    law_rows: Callable[..., Any] | None
    law_user: Any
    law_memory: int
    law_memory_names: str | Sequence[str] | None
    law_vectors: int
    law_stiffness: float
    law_range: float
    law_range_radii: float
    law_who: int
    law_rate: Callable[..., Any] | None
    body_reals: str | Sequence[str] | None
    body_reals_fn: Callable[..., Any] | None
    body_reals_user: Any
    growth: Callable[..., Any] | None
    growth_user: Any
    growth_interval: float
    groups: str | Sequence[str] | None
    force: Callable[..., Any] | None
    body_force: Callable[..., Any] | None
    force_user: Any
    integrator: Integrator
    dt: float
    allow_large_dt: int
    impact_speed: float
    response: Response
    cone: Cone
    solver: Solver
    sweeps: int
    tolerance: float
    cold_start: int
    unsolved_stops: int
    search: Search
    skin: float
    rotation: Rotation
    ellipsoid_overlap: Overlap
    cluster_contacts: ClusterContacts
    orientations: int
    overlap_stop: float
    ledger: int
    threads: int
    allocator: Allocator
    def __init__(self, *values: Any, gravity: Vec3 | _Numbers | None = ..., domain: Box | _Numbers | None = ..., boundary: Sequence[Boundary | str | int] = ..., planar: int = ..., thickness: float = ..., normal_law: NormalLaw | str | int = ..., tangent_law: TangentLaw | str | int = ..., rolling_law: RollingLaw | str | int = ..., tension: Tension | str | int = ..., friction_load: Load | str | int = ..., slider: Slider | str | int = ..., convention: Convention | str | int = ..., law: Callable[..., Any] | None = ..., law_rows: Callable[..., Any] | None = ..., law_user: Any = ..., law_memory: int = ..., law_memory_names: str | Sequence[str] | None = ..., law_vectors: int = ..., law_stiffness: float = ..., law_range: float = ..., law_range_radii: float = ..., law_who: int = ..., law_rate: Callable[..., Any] | None = ..., body_reals: str | Sequence[str] | None = ..., body_reals_fn: Callable[..., Any] | None = ..., body_reals_user: Any = ..., growth: Callable[..., Any] | None = ..., growth_user: Any = ..., growth_interval: float = ..., groups: str | Sequence[str] | None = ..., force: Callable[..., Any] | None = ..., body_force: Callable[..., Any] | None = ..., force_user: Any = ..., integrator: Integrator | str | int = ..., dt: float = ..., allow_large_dt: int = ..., impact_speed: float = ..., response: Response | str | int = ..., cone: Cone | str | int = ..., solver: Solver | str | int = ..., sweeps: int = ..., tolerance: float = ..., cold_start: int = ..., unsolved_stops: int = ..., search: Search | str | int = ..., skin: float = ..., rotation: Rotation | str | int = ..., ellipsoid_overlap: Overlap | str | int = ..., cluster_contacts: ClusterContacts | str | int = ..., orientations: int = ..., overlap_stop: float = ..., ledger: int = ..., threads: int = ..., allocator: Allocator | Mapping[str, Any] | None = ...) -> None: ...

class MaterialDesc(Struct):
    density: float
    young: float
    poisson: float
    restitution: float
    friction: float
    friction_static: float
    rolling_friction: float
    stiffness: float
    stiffness_ratio: float
    stiffness_unloading: float
    stiffness_adhesion: float
    def __init__(self, *values: Any, density: float = ..., young: float = ..., poisson: float = ..., restitution: float = ..., friction: float = ..., friction_static: float = ..., rolling_friction: float = ..., stiffness: float = ..., stiffness_ratio: float = ..., stiffness_unloading: float = ..., stiffness_adhesion: float = ...) -> None: ...

class Pair(Struct):
    young_eff: float
    shear_eff: float
    restitution: float
    friction: float
    friction_static: float
    rolling_friction: float
    stiffness: float
    stiffness_ratio: float
    tangent_damping: float
    normal_damping: float
    spinning_friction: float
    cohesion: float
    compliance: float
    stiffness_adhesion: float
    ignored: int
    def __init__(self, *values: Any, young_eff: float = ..., shear_eff: float = ..., restitution: float = ..., friction: float = ..., friction_static: float = ..., rolling_friction: float = ..., stiffness: float = ..., stiffness_ratio: float = ..., tangent_damping: float = ..., normal_damping: float = ..., spinning_friction: float = ..., cohesion: float = ..., compliance: float = ..., stiffness_adhesion: float = ..., ignored: int = ...) -> None: ...

class Coefficients(Struct):
    r_eff: float
    m_eff: float
    kn: float
    cn: float
    kt: float
    ct: float
    kun: float
    damping_ratio: float
    contact_time: float
    kad: float
    def __init__(self, *values: Any, r_eff: float = ..., m_eff: float = ..., kn: float = ..., cn: float = ..., kt: float = ..., ct: float = ..., kun: float = ..., damping_ratio: float = ..., contact_time: float = ..., kad: float = ...) -> None: ...

class Region(Struct):
    box: Box
    cylinder: int
    inside: Callable[..., Any] | None
    user: Any
    def __init__(self, *values: Any, box: Box | _Numbers | None = ..., cylinder: int = ..., inside: Callable[..., Any] | None = ..., user: Any = ...) -> None: ...

class Sizes(Struct):
    kind: SizesKind
    by_count: int
    min: float
    max: float
    median: float
    spread: float
    scale: float
    modulus: float
    count: int
    radius: Any
    passing: Any
    deviation: float
    def __init__(self, *values: Any, kind: SizesKind | str | int = ..., by_count: int = ..., min: float = ..., max: float = ..., median: float = ..., spread: float = ..., scale: float = ..., modulus: float = ..., count: int = ..., radius: _Array | None = ..., passing: _Array | None = ..., deviation: float = ...) -> None: ...

class BodyState(Struct):
    position: Vec3
    velocity: Vec3
    spin: Vec3
    force: Vec3
    torque: Vec3
    radius: float
    mass: float
    inertia: float
    material: Material
    fixed: int
    orientation: Quat
    shape: Shape
    moments: Vec3
    reals: Any
    def __init__(self, *values: Any, position: Vec3 | _Numbers | None = ..., velocity: Vec3 | _Numbers | None = ..., spin: Vec3 | _Numbers | None = ..., force: Vec3 | _Numbers | None = ..., torque: Vec3 | _Numbers | None = ..., radius: float = ..., mass: float = ..., inertia: float = ..., material: Material | None = ..., fixed: int = ..., orientation: Quat | _Numbers | None = ..., shape: Shape | None = ..., moments: Vec3 | _Numbers | None = ..., reals: _Array | None = ...) -> None: ...

class Bodies(Struct):
    count: int
    positions: Any
    velocities: Any
    spins: Any
    forces: Any
    torques: Any
    masses: Any
    slots: Any
    materials: Any
    orientations: Any
    shapes: Any
    real_count: int
    reals: Any
    rates: Any
    groups: Any
    def __init__(self, *values: Any, count: int = ..., positions: _Array | None = ..., velocities: _Array | None = ..., spins: _Array | None = ..., forces: _Array | None = ..., torques: _Array | None = ..., masses: _Array | None = ..., slots: _Array | None = ..., materials: _Array | None = ..., orientations: _Array | None = ..., shapes: _Array | None = ..., real_count: int = ..., reals: _Array | None = ..., rates: _Array | None = ..., groups: _Array | None = ...) -> None: ...

class Selection(Struct):
    group: Group
    material: Material
    shape: Shape
    radius_min: float
    radius_max: float
    region: Region | Mapping[str, Any] | _Numbers | None
    count: int
    bodies: Sequence[Body] | None
    def __init__(self, *values: Any, group: Group | None = ..., material: Material | None = ..., shape: Shape | None = ..., radius_min: float = ..., radius_max: float = ..., region: Region | Mapping[str, Any] | _Numbers | None = ..., count: int = ..., bodies: Sequence[Body] | None = ...) -> None: ...

class BodiesMeans(Struct):
    bodies: int
    mass: float
    centre: Any
    velocity: Any
    spin: Any
    radius: float
    force: Any
    kinetic: float
    rotational: float
    def __init__(self, *values: Any, bodies: int = ..., mass: float = ..., centre: _Array | None = ..., velocity: _Array | None = ..., spin: _Array | None = ..., radius: float = ..., force: _Array | None = ..., kinetic: float = ..., rotational: float = ...) -> None: ...

class ClusterDesc(Struct):
    count: int
    positions: Any
    radii: Any
    radius: float
    mass: ClusterMass
    rays: int
    volume: float
    centre: Vec3
    inertia: Any
    def __init__(self, *values: Any, count: int = ..., positions: _Array | None = ..., radii: _Array | None = ..., radius: float = ..., mass: ClusterMass | str | int = ..., rays: int = ..., volume: float = ..., centre: Vec3 | _Numbers | None = ..., inertia: _Array | None = ...) -> None: ...

class ShapeInfo(Struct):
    spheres: int
    corners: int
    faces: int
    volume: float
    centre: Vec3
    frame: Quat
    inertia: Vec3
    semi_axes: Vec3
    radius: float
    pieces: int
    def __init__(self, *values: Any, spheres: int = ..., corners: int = ..., faces: int = ..., volume: float = ..., centre: Vec3 | _Numbers | None = ..., frame: Quat | _Numbers | None = ..., inertia: Vec3 | _Numbers | None = ..., semi_axes: Vec3 | _Numbers | None = ..., radius: float = ..., pieces: int = ...) -> None: ...

class Ellipsoid(Struct):
    position: Vec3
    semi_axes: Vec3
    orientation: Quat
    def __init__(self, *values: Any, position: Vec3 | _Numbers | None = ..., semi_axes: Vec3 | _Numbers | None = ..., orientation: Quat | _Numbers | None = ...) -> None: ...

class EllipsoidContact(Struct):
    scale: float
    lambda_: float
    point: Vec3
    normal: Vec3
    depth_normal: float
    depth_chord: float
    depth_conservative: float
    iterations: int
    def __init__(self, *values: Any, scale: float = ..., lambda_: float = ..., point: Vec3 | _Numbers | None = ..., normal: Vec3 | _Numbers | None = ..., depth_normal: float = ..., depth_chord: float = ..., depth_conservative: float = ..., iterations: int = ...) -> None: ...

class BodyCounts(Struct):
    inserted: int
    present: int
    removed: int
    left: int
    def __init__(self, *values: Any, inserted: int = ..., present: int = ..., removed: int = ..., left: int = ...) -> None: ...

class MotionRow(Struct):
    time: float
    position: Vec3
    rotation: Quat
    load: float
    def __init__(self, *values: Any, time: float = ..., position: Vec3 | _Numbers | None = ..., rotation: Quat | _Numbers | None = ..., load: float = ...) -> None: ...

class Motion(Struct):
    kind: MotionKind
    velocity: Vec3
    point: Vec3
    axis: Vec3
    speed: float
    amplitude: float
    frequency: float
    phase: float
    start: float
    function: Callable[..., Any] | None
    user: Any
    ramp: float
    load: float
    area: float
    travel: float
    table: Sequence[MotionRow | Mapping[str, Any]] | None
    table_count: int
    table_repeats: int
    def __init__(self, *values: Any, kind: MotionKind | str | int = ..., velocity: Vec3 | _Numbers | None = ..., point: Vec3 | _Numbers | None = ..., axis: Vec3 | _Numbers | None = ..., speed: float = ..., amplitude: float = ..., frequency: float = ..., phase: float = ..., start: float = ..., function: Callable[..., Any] | None = ..., user: Any = ..., ramp: float = ..., load: float = ..., area: float = ..., travel: float = ..., table: Sequence[MotionRow | Mapping[str, Any]] | None = ..., table_count: int = ..., table_repeats: int = ...) -> None: ...

class Mesh(Struct):
    vertex_count: int
    triangle_count: int
    vertices: Any
    triangles: Any
    def __init__(self, *values: Any, vertex_count: int = ..., triangle_count: int = ..., vertices: _Array | None = ..., triangles: _Array | None = ...) -> None: ...

class Profile(Struct):
    vertex_count: int
    segment_count: int
    vertices: Any
    segments: Any
    def __init__(self, *values: Any, vertex_count: int = ..., segment_count: int = ..., vertices: _Array | None = ..., segments: _Array | None = ...) -> None: ...

class SieveDesc(Struct):
    kind: SieveKind
    point: Vec3
    normal: Vec3
    along: Vec3
    aperture: float
    bar: float
    length: float
    thickness: float
    lift: float
    staggered: int
    radius: float
    model: int
    clearance: float
    def __init__(self, *values: Any, kind: SieveKind | str | int = ..., point: Vec3 | _Numbers | None = ..., normal: Vec3 | _Numbers | None = ..., along: Vec3 | _Numbers | None = ..., aperture: float = ..., bar: float = ..., length: float = ..., thickness: float = ..., lift: float = ..., staggered: int = ..., radius: float = ..., model: int = ..., clearance: float = ...) -> None: ...

class WallLoads(Struct):
    force: Vec3
    torque: Vec3
    torque_axial: float
    power: float
    contacts: int
    touched: int
    impulse: Any
    torque_impulse: float
    work: float
    time: float
    rate: Any
    gained: Any
    def __init__(self, *values: Any, force: Vec3 | _Numbers | None = ..., torque: Vec3 | _Numbers | None = ..., torque_axial: float = ..., power: float = ..., contacts: int = ..., touched: int = ..., impulse: _Array | None = ..., torque_impulse: float = ..., work: float = ..., time: float = ..., rate: _Array | None = ..., gained: _Array | None = ...) -> None: ...

class Joint(Id):
    id: int
    def __init__(self, id: int = ...) -> None: ...
    def motor_set(self, motor: Motor | str | int, speed: float, torque: float) -> None: ...
    @property
    def state(self) -> JointState: ...
    def remove(self) -> None: ...

class JointDesc(Struct):
    kind: JointKind
    motor: Motor
    a: Body
    b: Body
    wall: Wall
    collide: int
    point: Vec3
    axis: Vec3
    speed: float
    torque: float
    def __init__(self, *values: Any, kind: JointKind | str | int = ..., motor: Motor | str | int = ..., a: Body | None = ..., b: Body | None = ..., wall: Wall | None = ..., collide: int = ..., point: Vec3 | _Numbers | None = ..., axis: Vec3 | _Numbers | None = ..., speed: float = ..., torque: float = ...) -> None: ...

class JointState(Struct):
    force: Vec3
    torque: Vec3
    motor_torque: float
    power: float
    gap: float
    tilt: float
    turned: float
    work: float
    def __init__(self, *values: Any, force: Vec3 | _Numbers | None = ..., torque: Vec3 | _Numbers | None = ..., motor_torque: float = ..., power: float = ..., gap: float = ..., tilt: float = ..., turned: float = ..., work: float = ...) -> None: ...

class RailDesc(Struct):
    axes: int
    velocity: Vec3
    spin: Vec3
    wall: Wall
    def __init__(self, *values: Any, axes: int = ..., velocity: Vec3 | _Numbers | None = ..., spin: Vec3 | _Numbers | None = ..., wall: Wall | None = ...) -> None: ...

class RailState(Struct):
    desc: RailDesc
    force: Vec3
    torque: Vec3
    power: float
    work: float
    def __init__(self, *values: Any, desc: RailDesc | Mapping[str, Any] | None = ..., force: Vec3 | _Numbers | None = ..., torque: Vec3 | _Numbers | None = ..., power: float = ..., work: float = ...) -> None: ...

class Feed(Id):
    id: int
    def __init__(self, id: int = ...) -> None: ...
    @property
    def state(self) -> FeedState: ...

class Outlet(Id):
    id: int
    def __init__(self, id: int = ...) -> None: ...
    @property
    def state(self) -> OutletState: ...
    def reset(self) -> None: ...
    def residence_csv_write(self, path: str | os.PathLike[str]) -> None: ...

class FeedDesc(Struct):
    material: Material
    class_count: int
    radius: Any
    amount: Any
    limited: int
    by_mass: int
    rate: float
    start: float
    end: float
    box: Box
    round: int
    velocity: Vec3
    spread: float
    seed: int
    inside: Callable[..., Any] | None
    inside_user: Any
    materials: Sequence[Material] | None
    shapes: Sequence[Shape] | None
    sizes: Sequence[Sizes | Mapping[str, Any]] | None
    def __init__(self, *values: Any, material: Material | None = ..., class_count: int = ..., radius: _Array | None = ..., amount: _Array | None = ..., limited: int = ..., by_mass: int = ..., rate: float = ..., start: float = ..., end: float = ..., box: Box | _Numbers | None = ..., round: int = ..., velocity: Vec3 | _Numbers | None = ..., spread: float = ..., seed: int = ..., inside: Callable[..., Any] | None = ..., inside_user: Any = ..., materials: Sequence[Material] | None = ..., shapes: Sequence[Shape] | None = ..., sizes: Sequence[Sizes | Mapping[str, Any]] | None = ...) -> None: ...

class FeedState(Struct):
    fed: Any
    total: int
    mass: float
    waiting: int
    done: int
    def __init__(self, *values: Any, fed: _Array | None = ..., total: int = ..., mass: float = ..., waiting: int = ..., done: int = ...) -> None: ...

class OutletDesc(Struct):
    frame: Wall
    box: Box
    beyond: float
    wanted_min: float
    wanted_max: float
    class_count: int
    radius: Any
    material: Material
    keep: int
    residence_bin: float
    def __init__(self, *values: Any, frame: Wall | None = ..., box: Box | _Numbers | None = ..., beyond: float = ..., wanted_min: float = ..., wanted_max: float = ..., class_count: int = ..., radius: _Array | None = ..., material: Material | None = ..., keep: int = ..., residence_bin: float = ...) -> None: ...

class OutletState(Struct):
    count: Any
    total: int
    mass: Any
    total_mass: float
    sorted: int
    gangue: int
    sorted_mass: float
    gangue_mass: float
    since: float
    last: float
    back: Any
    held: Any
    back_total: int
    held_total: int
    back_mass: Any
    held_mass: Any
    back_total_mass: float
    held_total_mass: float
    residence: Any
    residence_square: Any
    residence_count: Any
    def __init__(self, *values: Any, count: _Array | None = ..., total: int = ..., mass: _Array | None = ..., total_mass: float = ..., sorted: int = ..., gangue: int = ..., sorted_mass: float = ..., gangue_mass: float = ..., since: float = ..., last: float = ..., back: _Array | None = ..., held: _Array | None = ..., back_total: int = ..., held_total: int = ..., back_mass: _Array | None = ..., held_mass: _Array | None = ..., back_total_mass: float = ..., held_total_mass: float = ..., residence: _Array | None = ..., residence_square: _Array | None = ..., residence_count: _Array | None = ...) -> None: ...

class Advice(Struct):
    dt: float
    dt_max: float
    contact_time: float
    rayleigh: float
    speed: float
    binds: str
    def __init__(self, *values: Any, dt: float = ..., dt_max: float = ..., contact_time: float = ..., rayleigh: float = ..., speed: float = ..., binds: str = ...) -> None: ...

class Finding(Struct):
    severity: Severity
    text: str
    def __init__(self, severity: Severity | str | int = ..., text: str = ...) -> None: ...

class CellDesc(Struct):
    rate: Vec3
    shear: float
    stress: Vec3
    rate_most: Vec3
    def __init__(self, *values: Any, rate: Vec3 | _Numbers | None = ..., shear: float = ..., stress: Vec3 | _Numbers | None = ..., rate_most: Vec3 | _Numbers | None = ...) -> None: ...

class CellState(Struct):
    box: Box
    offset: float
    strain: Any
    shear: float
    rate: Any
    shear_rate: float
    stress: Any
    def __init__(self, *values: Any, box: Box | _Numbers | None = ..., offset: float = ..., strain: _Array | None = ..., shear: float = ..., rate: _Array | None = ..., shear_rate: float = ..., stress: _Array | None = ...) -> None: ...

class Counters(Struct):
    steps: int
    rebuilds: int
    candidates: int
    contacts: int
    wall_contacts: int
    overlap_max: float
    speed_max: float
    skin: float
    dt: float
    search: Search
    threads: int
    domains: int
    sweeps: int
    residual: float
    residual_rms: float
    unsolved: int
    memory: int
    def __init__(self, *values: Any, steps: int = ..., rebuilds: int = ..., candidates: int = ..., contacts: int = ..., wall_contacts: int = ..., overlap_max: float = ..., speed_max: float = ..., skin: float = ..., dt: float = ..., search: Search | str | int = ..., threads: int = ..., domains: int = ..., sweeps: int = ..., residual: float = ..., residual_rms: float = ..., unsolved: int = ..., memory: int = ...) -> None: ...

class Ledger(Struct):
    kinetic: float
    rotational: float
    elastic: float
    gravity: float
    walls: float
    force: float
    cell: float
    inserted: float
    normal: float
    slide: float
    tangent: float
    rolling: float
    removed: float
    throughput: float
    growth: float
    residual: float
    unknown: float
    def __init__(self, *values: Any, kinetic: float = ..., rotational: float = ..., elastic: float = ..., gravity: float = ..., walls: float = ..., force: float = ..., cell: float = ..., inserted: float = ..., normal: float = ..., slide: float = ..., tangent: float = ..., rolling: float = ..., removed: float = ..., throughput: float = ..., growth: float = ..., residual: float = ..., unknown: float = ...) -> None: ...

class Totals(Struct):
    mass: float
    kinetic: float
    rotational: float
    centre: Any
    momentum: Any
    angular: Any
    def __init__(self, *values: Any, mass: float = ..., kinetic: float = ..., rotational: float = ..., centre: _Array | None = ..., momentum: _Array | None = ..., angular: _Array | None = ...) -> None: ...

class Observable(Struct):
    name: str | None
    unit: str | None
    function: Callable[..., Any] | None
    user: Any
    scale: float
    def __init__(self, *values: Any, name: str | None = ..., unit: str | None = ..., function: Callable[..., Any] | None = ..., user: Any = ..., scale: float = ...) -> None: ...

class TrialsDesc(Struct):
    duration: float
    budget: float
    tolerance: float
    seeds: int
    observable_count: int
    observables: Sequence[Observable | Mapping[str, Any]] | None
    progress: Callable[..., Any] | None
    user: Any
    def __init__(self, *values: Any, duration: float = ..., budget: float = ..., tolerance: float = ..., seeds: int = ..., observable_count: int = ..., observables: Sequence[Observable | Mapping[str, Any]] | None = ..., progress: Callable[..., Any] | None = ..., user: Any = ...) -> None: ...

class Trial(Struct):
    name: str | None
    step: float
    stiffness: float
    dt: float
    done: int
    seconds: float
    value: Any
    error: Any
    drift: Any
    promise: float
    refusal: str
    def __init__(self, *values: Any, name: str | None = ..., step: float = ..., stiffness: float = ..., dt: float = ..., done: int = ..., seconds: float = ..., value: _Array | None = ..., error: _Array | None = ..., drift: _Array | None = ..., promise: float = ..., refusal: str = ...) -> None: ...

class Trials(Struct):
    count: int
    best: int
    reference: int
    duration: float
    tolerance: float
    seeds: int
    observable_count: int
    observables: Sequence[Observable | Mapping[str, Any]] | None
    trial: Sequence[Trial | Mapping[str, Any]] | None
    advice: str
    def __init__(self, *values: Any, count: int = ..., best: int = ..., reference: int = ..., duration: float = ..., tolerance: float = ..., seeds: int = ..., observable_count: int = ..., observables: Sequence[Observable | Mapping[str, Any]] | None = ..., trial: Sequence[Trial | Mapping[str, Any]] | None = ..., advice: str = ...) -> None: ...

class ContactInfo(Struct):
    a: Body
    b: Body
    wall: int
    point: Vec3
    normal: Vec3
    overlap: float
    force: Vec3
    further: int
    def __init__(self, *values: Any, a: Body | None = ..., b: Body | None = ..., wall: int = ..., point: Vec3 | _Numbers | None = ..., normal: Vec3 | _Numbers | None = ..., overlap: float = ..., force: Vec3 | _Numbers | None = ..., further: int = ...) -> None: ...

class Event(Struct):
    kind: EventKind
    a: Body
    b: Body
    wall: int
    material_a: Material
    material_b: Material
    cut: int
    point: Vec3
    normal: Vec3
    begin: float
    end: float
    closing_speed: float
    slip_speed: float
    mass: float
    force: float
    impulse: float
    lost_normal: float
    lost_slide: float
    lost_tangent: float
    lost_rolling: float
    def __init__(self, *values: Any, kind: EventKind | str | int = ..., a: Body | None = ..., b: Body | None = ..., wall: int = ..., material_a: Material | None = ..., material_b: Material | None = ..., cut: int = ..., point: Vec3 | _Numbers | None = ..., normal: Vec3 | _Numbers | None = ..., begin: float = ..., end: float = ..., closing_speed: float = ..., slip_speed: float = ..., mass: float = ..., force: float = ..., impulse: float = ..., lost_normal: float = ..., lost_slide: float = ..., lost_tangent: float = ..., lost_rolling: float = ...) -> None: ...

class EventsDesc(Struct):
    function: Callable[..., Any] | None
    user: Any
    begins: int
    def __init__(self, *values: Any, function: Callable[..., Any] | None = ..., user: Any = ..., begins: int = ...) -> None: ...

class Impacts(Struct):
    seconds: float
    ended: float
    open: int
    rate: float
    lost_normal: float
    lost_slide: float
    lost_tangent: float
    lost_rolling: float
    bin: Any
    impacts: Any
    losses: Any
    energy: Any
    def __init__(self, *values: Any, seconds: float = ..., ended: float = ..., open: int = ..., rate: float = ..., lost_normal: float = ..., lost_slide: float = ..., lost_tangent: float = ..., lost_rolling: float = ..., bin: _Array | None = ..., impacts: _Array | None = ..., losses: _Array | None = ..., energy: _Array | None = ...) -> None: ...

class Wear(Struct):
    seconds: float
    slide: float
    normal: float
    volume: float
    def __init__(self, *values: Any, seconds: float = ..., slide: float = ..., normal: float = ..., volume: float = ...) -> None: ...

class Servo(Struct):
    target: float
    force: float
    speed: float
    travel: float
    stiffness: float
    damping: float
    time: float
    def __init__(self, *values: Any, target: float = ..., force: float = ..., speed: float = ..., travel: float = ..., stiffness: float = ..., damping: float = ..., time: float = ...) -> None: ...

class Stress(Struct):
    volume: float
    solid: float
    contact: Any
    kinetic: Any
    total: Any
    fabric: Any
    contacts: int
    coordination: float
    def __init__(self, *values: Any, volume: float = ..., solid: float = ..., contact: _Array | None = ..., kinetic: _Array | None = ..., total: _Array | None = ..., fabric: _Array | None = ..., contacts: int = ..., coordination: float = ...) -> None: ...

class FieldDesc(Struct):
    box: Box
    cells: Any
    start: float
    end: float
    interval: float
    material: Material
    radius_min: float
    radius_max: float
    stress: int
    width: float
    group: Group
    variance: int
    bodies: int
    def __init__(self, *values: Any, box: Box | _Numbers | None = ..., cells: _Array | None = ..., start: float = ..., end: float = ..., interval: float = ..., material: Material | None = ..., radius_min: float = ..., radius_max: float = ..., stress: int = ..., width: float = ..., group: Group | None = ..., variance: int = ..., bodies: int = ...) -> None: ...

class FieldData(Struct):
    cells: Any
    box: Box
    samples: int
    solid: Any
    mass: Any
    momentum: Any
    grains: Any
    flux: Any
    stress: Any
    contacts: Any
    def __init__(self, *values: Any, cells: _Array | None = ..., box: Box | _Numbers | None = ..., samples: int = ..., solid: _Array | None = ..., mass: _Array | None = ..., momentum: _Array | None = ..., grains: _Array | None = ..., flux: _Array | None = ..., stress: _Array | None = ..., contacts: _Array | None = ...) -> None: ...

class FieldCell(Struct):
    grains: float
    solid: float
    density: float
    velocity: Any
    temperature: float
    stress: Any
    coordination: float
    grains_variance: float
    solid_variance: float
    density_variance: float
    velocity_variance: Any
    def __init__(self, *values: Any, grains: float = ..., solid: float = ..., density: float = ..., velocity: _Array | None = ..., temperature: float = ..., stress: _Array | None = ..., coordination: float = ..., grains_variance: float = ..., solid_variance: float = ..., density_variance: float = ..., velocity_variance: _Array | None = ...) -> None: ...

class BodyMeans(Struct):
    samples: int
    velocity: Any
    velocity_variance: Any
    spin: Any
    spin_variance: Any
    force: Any
    force_variance: Any
    def __init__(self, *values: Any, samples: int = ..., velocity: _Array | None = ..., velocity_variance: _Array | None = ..., spin: _Array | None = ..., spin_variance: _Array | None = ..., force: _Array | None = ..., force_variance: _Array | None = ...) -> None: ...

class MixingDesc(Struct):
    box: Box
    cells: Any
    material: Material
    radius_min: float
    radius_max: float
    centre: Vec3
    axis: Vec3
    def __init__(self, *values: Any, box: Box | _Numbers | None = ..., cells: _Array | None = ..., material: Material | None = ..., radius_min: float = ..., radius_max: float = ..., centre: Vec3 | _Numbers | None = ..., axis: Vec3 | _Numbers | None = ...) -> None: ...

class Mixing(Struct):
    grains: int
    part: int
    cells: int
    fraction: float
    variance: float
    variance_segregated: float
    variance_random: float
    lacey: float
    kramer: float
    segregation: Any
    segregation_radial: float
    contacts: int
    contact_segregation: float
    def __init__(self, *values: Any, grains: int = ..., part: int = ..., cells: int = ..., fraction: float = ..., variance: float = ..., variance_segregated: float = ..., variance_random: float = ..., lacey: float = ..., kramer: float = ..., segregation: _Array | None = ..., segregation_radial: float = ..., contacts: int = ..., contact_segregation: float = ...) -> None: ...

class Repose(Struct):
    angle: float
    error: float
    places: int
    def __init__(self, *values: Any, angle: float = ..., error: float = ..., places: int = ...) -> None: ...

class MeshHealth(Struct):
    open_edges: int
    crowded_edges: int
    duplicates: int
    shells: int
    flipped: int
    twisted_edges: int
    slivers: int
    merged_vertices: int
    split_faces: int
    bent_faces: int
    crossed_faces: int
    box: Box
    hint: str
    def __init__(self, *values: Any, open_edges: int = ..., crowded_edges: int = ..., duplicates: int = ..., shells: int = ..., flipped: int = ..., twisted_edges: int = ..., slivers: int = ..., merged_vertices: int = ..., split_faces: int = ..., bent_faces: int = ..., crossed_faces: int = ..., box: Box | _Numbers | None = ..., hint: str = ...) -> None: ...

class SpheresFit(Struct):
    volume: float
    centre: Vec3
    inertia: Any
    volume_error: float
    inertia_error: float
    surface_error: float
    wrong: float
    def __init__(self, *values: Any, volume: float = ..., centre: Vec3 | _Numbers | None = ..., inertia: _Array | None = ..., volume_error: float = ..., inertia_error: float = ..., surface_error: float = ..., wrong: float = ...) -> None: ...

class WallPart(Struct):
    name: str | None
    material: Material
    motion: Motion
    def __init__(self, *values: Any, name: str | None = ..., material: Material | None = ..., motion: Motion | Mapping[str, Any] | None = ...) -> None: ...

class Grains(Struct):
    count: int
    positions: Any
    radii: Any
    velocities: Any
    spins: Any
    materials: Any
    lines_left: int
    ignored: str
    def __init__(self, *values: Any, count: int = ..., positions: _Array | None = ..., radii: _Array | None = ..., velocities: _Array | None = ..., spins: _Array | None = ..., materials: _Array | None = ..., lines_left: int = ..., ignored: str = ...) -> None: ...

class ReplayDesc(Struct):
    title: str | None
    number: str | None
    number_fn: Callable[..., Any] | None
    user: Any
    resolution: float
    interval: float
    contacts: int
    def __init__(self, *values: Any, title: str | None = ..., number: str | None = ..., number_fn: Callable[..., Any] | None = ..., user: Any = ..., resolution: float = ..., interval: float = ..., contacts: int = ...) -> None: ...

class Output(Id):
    id: int
    def __init__(self, id: int = ...) -> None: ...
    def remove(self) -> None: ...

class OutputDesc(Struct):
    kind: OutputKind
    path: str | os.PathLike[str] | None
    interval: float
    start: float
    end: float
    wall: Wall
    columns: str | Sequence[str] | None
    values: Callable[..., Any] | None
    function: Callable[..., Any] | None
    user: Any
    mixing: MixingDesc
    field: Field
    z0: float
    z1: float
    outlet: Outlet
    def __init__(self, *values: Any, kind: OutputKind | str | int = ..., path: str | os.PathLike[str] | None = ..., interval: float = ..., start: float = ..., end: float = ..., wall: Wall | None = ..., columns: str | Sequence[str] | None = ..., values: Callable[..., Any] | None = ..., function: Callable[..., Any] | None = ..., user: Any = ..., mixing: MixingDesc | Mapping[str, Any] | None = ..., field: Field | None = ..., z0: float = ..., z1: float = ..., outlet: Outlet | None = ...) -> None: ...

class Transport(Struct):
    exchange_fn: Callable[..., Any] | None
    reduce_fn: Callable[..., Any] | None
    user: Any
    def __init__(self, *values: Any, exchange_fn: Callable[..., Any] | None = ..., reduce_fn: Callable[..., Any] | None = ..., user: Any = ...) -> None: ...

class SlabsDesc(Struct):
    axis: int
    count: int
    first: int
    local: int
    transport: Transport
    balance: float
    balance_interval: int
    def __init__(self, *values: Any, axis: int = ..., count: int = ..., first: int = ..., local: int = ..., transport: Transport | Mapping[str, Any] | None = ..., balance: float = ..., balance_interval: int = ...) -> None: ...

class Slab(Struct):
    grains: int
    ghosts: int
    lo: float
    hi: float
    work: float
    seconds: float
    bytes: int
    def __init__(self, *values: Any, grains: int = ..., ghosts: int = ..., lo: float = ..., hi: float = ..., work: float = ..., seconds: float = ..., bytes: int = ...) -> None: ...

class SlabsCounters(Struct):
    time: float
    steps: int
    rebuilds: int
    border_moves: int
    migrated: int
    skin: float
    dt: float
    def __init__(self, *values: Any, time: float = ..., steps: int = ..., rebuilds: int = ..., border_moves: int = ..., migrated: int = ..., skin: float = ..., dt: float = ...) -> None: ...

class Effect(Struct):
    name: str | None
    state: EffectState
    share: float
    error: float
    measured: int
    missing: int
    text: str
    def __init__(self, *values: Any, name: str | None = ..., state: EffectState | str | int = ..., share: float = ..., error: float = ..., measured: int = ..., missing: int = ..., text: str = ...) -> None: ...

class World(WorldBase):
    def __init__(self, *, gravity: Vec3 | _Numbers | None = ..., domain: Box | _Numbers | None = ..., boundary: Sequence[Boundary | str | int] = ..., planar: int = ..., thickness: float = ..., normal_law: NormalLaw | str | int = ..., tangent_law: TangentLaw | str | int = ..., rolling_law: RollingLaw | str | int = ..., tension: Tension | str | int = ..., friction_load: Load | str | int = ..., slider: Slider | str | int = ..., convention: Convention | str | int = ..., law: Callable[..., Any] | None = ..., law_rows: Callable[..., Any] | None = ..., law_user: Any = ..., law_memory: int = ..., law_memory_names: str | Sequence[str] | None = ..., law_vectors: int = ..., law_stiffness: float = ..., law_range: float = ..., law_range_radii: float = ..., law_who: int = ..., law_rate: Callable[..., Any] | None = ..., body_reals: str | Sequence[str] | None = ..., body_reals_fn: Callable[..., Any] | None = ..., body_reals_user: Any = ..., growth: Callable[..., Any] | None = ..., growth_user: Any = ..., growth_interval: float = ..., groups: str | Sequence[str] | None = ..., force: Callable[..., Any] | None = ..., body_force: Callable[..., Any] | None = ..., force_user: Any = ..., integrator: Integrator | str | int = ..., dt: float = ..., allow_large_dt: int = ..., impact_speed: float = ..., response: Response | str | int = ..., cone: Cone | str | int = ..., solver: Solver | str | int = ..., sweeps: int = ..., tolerance: float = ..., cold_start: int = ..., unsolved_stops: int = ..., search: Search | str | int = ..., skin: float = ..., rotation: Rotation | str | int = ..., ellipsoid_overlap: Overlap | str | int = ..., cluster_contacts: ClusterContacts | str | int = ..., orientations: int = ..., overlap_stop: float = ..., ledger: int = ..., threads: int = ..., allocator: Allocator | Mapping[str, Any] | None = ...) -> None: ...
    @property
    def error(self) -> str: ...
    @property
    def desc(self) -> WorldDesc: ...
    def material(self, *, density: float = ..., young: float = ..., poisson: float = ..., restitution: float = ..., friction: float = ..., friction_static: float = ..., rolling_friction: float = ..., stiffness: float = ..., stiffness_ratio: float = ..., stiffness_unloading: float = ..., stiffness_adhesion: float = ...) -> Material: ...
    def pair(self, a: Material, b: Material) -> Pair: ...
    def pair_set(self, a: Material, b: Material, *, young_eff: float = ..., shear_eff: float = ..., restitution: float = ..., friction: float = ..., friction_static: float = ..., rolling_friction: float = ..., stiffness: float = ..., stiffness_ratio: float = ..., tangent_damping: float = ..., normal_damping: float = ..., spinning_friction: float = ..., cohesion: float = ..., compliance: float = ..., stiffness_adhesion: float = ..., ignored: int = ...) -> None: ...
    def coefficients(self, a: Material, b: Material, radius_a: float, radius_b: float) -> Coefficients: ...
    def pairs_print(self, out: TextIO | None = ...) -> None: ...
    def sphere(self, material: Material, radius: float, position: Vec3 | _Numbers) -> Body: ...
    def spheres(self, material: Material, positions: _Array, velocities: _Array | None = ..., radii: _Array | None = ..., radius: float = ...) -> None: ...
    def spheres_fill(self, material: Material, radius: float, region: Region | Mapping[str, Any] | _Numbers, count: int, seed: int) -> int: ...
    def sizes_finer(self, sizes: Sizes | Mapping[str, Any], radius: float) -> float: ...
    def sizes_draw(self, sizes: Sizes | Mapping[str, Any], count: int, seed: int) -> ctypes.Array[Any]: ...
    def sizes_classes(self, sizes: Sizes | Mapping[str, Any], class_count: int) -> tuple[list[float], list[float]]: ...
    def sizes_fill(self, material: Material, sizes: Sizes | Mapping[str, Any], region: Region | Mapping[str, Any] | _Numbers, count: int, seed: int) -> int: ...
    def spheres_pack(self, material: Material, radius: float, padding: float, region: Region | Mapping[str, Any] | _Numbers, count: int = ...) -> int: ...
    @property
    def temperature(self) -> float: ...
    def temperature_set(self, temperature: float, seed: int = ...) -> None: ...
    @property
    def bodies_memory(self) -> Bodies: ...
    def body_id(self, index: int) -> Body: ...
    def group(self, name: str) -> Group: ...
    def bodies_select(self, selection: Selection | Mapping[str, Any]) -> list[Body]: ...
    def bodies_group_set(self, selection: Selection | Mapping[str, Any], group: Group, member: int) -> int: ...
    def bodies_velocity_set(self, selection: Selection | Mapping[str, Any], velocity: Vec3 | _Numbers, spin: Vec3 | _Numbers) -> int: ...
    def bodies_fixed_set(self, selection: Selection | Mapping[str, Any], fixed: int) -> int: ...
    def bodies_remove(self, *, group: Group | None = ..., material: Material | None = ..., shape: Shape | None = ..., radius_min: float = ..., radius_max: float = ..., region: Region | Mapping[str, Any] | _Numbers | None = ..., count: int = ..., bodies: Sequence[Body] | None = ...) -> int: ...
    def bodies_means(self, *, group: Group | None = ..., material: Material | None = ..., shape: Shape | None = ..., radius_min: float = ..., radius_max: float = ..., region: Region | Mapping[str, Any] | _Numbers | None = ..., count: int = ..., bodies: Sequence[Body] | None = ...) -> BodiesMeans: ...
    def bodies_reals_set(self, reals: _Array) -> None: ...
    def shape_ellipsoid(self, semi_axes: Vec3 | _Numbers) -> Shape: ...
    def shape_cluster(self, *, count: int = ..., positions: _Array | None = ..., radii: _Array | None = ..., radius: float = ..., mass: ClusterMass | str | int = ..., rays: int = ..., volume: float = ..., centre: Vec3 | _Numbers | None = ..., inertia: _Array | None = ...) -> Shape: ...
    def shape_polyhedron(self, points: _Array) -> Shape: ...
    def shape_mesh(self, mesh: Mesh | Mapping[str, Any], dent: float = ...) -> Shape: ...
    def shape_union(self, shapes: Sequence[Shape] | None, positions: _Array | None = ..., orientations: _Array | None = ...) -> Shape: ...
    def shape_polygon(self, points: _Array) -> Shape: ...
    def body(self, material: Material, shape: Shape, position: Vec3 | _Numbers, orientation: Quat | _Numbers = ...) -> Body: ...
    def bodies_add(self, material: Material, shape: Shape, positions: _Array, orientations: _Array | None = ..., velocities: _Array | None = ..., spins: _Array | None = ..., scales: _Array | None = ...) -> None: ...
    def bodies_fill(self, material: Material, shape: Shape, region: Region | Mapping[str, Any] | _Numbers, count: int, seed: int) -> int: ...
    @property
    def body_counts(self) -> BodyCounts: ...
    def wall_plane(self, material: Material, point: Vec3 | _Numbers, normal: Vec3 | _Numbers) -> Wall: ...
    def wall_cylinder(self, material: Material, point: Vec3 | _Numbers, axis: Vec3 | _Numbers, radius: float, inside: int) -> Wall: ...
    def wall_revolved(self, material: Material, point: Vec3 | _Numbers, axis: Vec3 | _Numbers, radii: _Array, heights: _Array) -> Wall: ...
    def wall_cone(self, material: Material, from_: Vec3 | _Numbers, to: Vec3 | _Numbers, radius_from: float, radius_to: float) -> Wall: ...
    def wall_profile(self, material: Material, profile: Profile | Mapping[str, Any], rule: EdgeRule | str | int = ...) -> Wall: ...
    def wall_mesh(self, material: Material, mesh: Mesh | Mapping[str, Any]) -> Wall: ...
    def wall_grains(self, material: Material, positions: _Array, radius: float, share: float) -> Wall: ...
    def wall_sieve(self, material: Material, *, kind: SieveKind | str | int = ..., point: Vec3 | _Numbers | None = ..., normal: Vec3 | _Numbers | None = ..., along: Vec3 | _Numbers | None = ..., aperture: float = ..., bar: float = ..., length: float = ..., thickness: float = ..., lift: float = ..., staggered: int = ..., radius: float = ..., model: int = ..., clearance: float = ...) -> Wall: ...
    def sieve_blinded(self, sieve: Wall, speed: float = ...) -> int: ...
    def joint(self, *, kind: JointKind | str | int = ..., motor: Motor | str | int = ..., a: Body | None = ..., b: Body | None = ..., wall: Wall | None = ..., collide: int = ..., point: Vec3 | _Numbers | None = ..., axis: Vec3 | _Numbers | None = ..., speed: float = ..., torque: float = ...) -> Joint: ...
    def feed(self, *, material: Material | None = ..., class_count: int = ..., radius: _Array | None = ..., amount: _Array | None = ..., limited: int = ..., by_mass: int = ..., rate: float = ..., start: float = ..., end: float = ..., box: Box | _Numbers | None = ..., round: int = ..., velocity: Vec3 | _Numbers | None = ..., spread: float = ..., seed: int = ..., inside: Callable[..., Any] | None = ..., inside_user: Any = ..., materials: Sequence[Material] | None = ..., shapes: Sequence[Shape] | None = ..., sizes: Sequence[Sizes | Mapping[str, Any]] | None = ...) -> Feed: ...
    def outlet(self, *, frame: Wall | None = ..., box: Box | _Numbers | None = ..., beyond: float = ..., wanted_min: float = ..., wanted_max: float = ..., class_count: int = ..., radius: _Array | None = ..., material: Material | None = ..., keep: int = ..., residence_bin: float = ...) -> Outlet: ...
    @property
    def step_advice(self) -> Advice: ...
    def check(self) -> list[Finding]: ...
    def check_print(self, out: TextIO | None = ...) -> int | None: ...
    def step(self, steps: int = ...) -> None: ...
    def run(self, seconds: float, progress: Callable[..., Any] | None = ...) -> None: ...
    def run_to(self, time: float, progress: Callable[..., Any] | None = ...) -> None: ...
    def settle(self, seconds: float, speed: float = ..., progress: Callable[..., Any] | None = ...) -> None: ...
    def gravity_set(self, gravity: Vec3 | _Numbers) -> None: ...
    def cell_set(self, *, rate: Vec3 | _Numbers | None = ..., shear: float = ..., stress: Vec3 | _Numbers | None = ..., rate_most: Vec3 | _Numbers | None = ...) -> None: ...
    @property
    def cell_state(self) -> CellState: ...
    def dt_set(self, dt: float) -> None: ...
    @property
    def time(self) -> float: ...
    @property
    def steps(self) -> int: ...
    @property
    def hash(self) -> int: ...
    @property
    def counters(self) -> Counters: ...
    def overlap_max_reset(self) -> None: ...
    @property
    def ledger(self) -> Ledger: ...
    @property
    def totals(self) -> Totals: ...
    def observer_height(self) -> float: ...
    def observer_kinetic(self) -> float: ...
    def observer_contacts(self) -> float: ...
    def observer_walls(self) -> float: ...
    def trials_run(self, *, duration: float = ..., budget: float = ..., tolerance: float = ..., seeds: int = ..., observable_count: int = ..., observables: Sequence[Observable | Mapping[str, Any]] | None = ..., progress: Callable[..., Any] | None = ..., user: Any = ...) -> Trials: ...
    @property
    def contacts(self) -> Structs: ...
    def contacts_each(self, fn: Callable[..., Any] | None = ...) -> int: ...
    def bonds_make(self, gap: float, make: Callable[..., Any] | None) -> int: ...
    @property
    def candidates(self) -> list[int]: ...
    def candidates_rebuild(self) -> None: ...
    def events_record(self, *, function: Callable[..., Any] | None = ..., user: Any = ..., begins: int = ...) -> None: ...
    def events_stop(self) -> None: ...
    def events_open_each(self, fn: Callable[..., Any] | None = ...) -> int: ...
    def impacts(self, a: Material | None = ..., b: Material | None = ...) -> Impacts: ...
    def impacts_csv_write(self, path: str | os.PathLike[str]) -> None: ...
    @property
    def stress(self) -> Stress: ...
    def field(self, *, box: Box | _Numbers | None = ..., cells: _Array | None = ..., start: float = ..., end: float = ..., interval: float = ..., material: Material | None = ..., radius_min: float = ..., radius_max: float = ..., stress: int = ..., width: float = ..., group: Group | None = ..., variance: int = ..., bodies: int = ...) -> Field: ...
    def mixing(self, *, box: Box | _Numbers | None = ..., cells: _Array | None = ..., material: Material | None = ..., radius_min: float = ..., radius_max: float = ..., centre: Vec3 | _Numbers | None = ..., axis: Vec3 | _Numbers | None = ...) -> Mixing: ...
    def repose_heap(self, box: Box | _Numbers | None = ...) -> Repose: ...
    def repose_drum(self, box: Box | _Numbers, axis: Vec3 | _Numbers) -> Repose: ...
    def mesh_read(self, path: str | os.PathLike[str]) -> tuple[Mesh, MeshHealth]: ...
    def mesh_parse(self, name: str, data: str | bytes) -> tuple[Mesh, MeshHealth]: ...
    def mesh_part_read(self, path: str | os.PathLike[str], part: str) -> tuple[Mesh, MeshHealth]: ...
    def mesh_place(self, mesh: Mesh | Mapping[str, Any], scale: float, rotation: Quat | _Numbers, to: Vec3 | _Numbers) -> None: ...
    def mesh_spheres(self, mesh: Mesh | Mapping[str, Any], count: int) -> tuple[ctypes.Array[Any], ctypes.Array[Any], SpheresFit]: ...
    def wall_parts(self, path: str | os.PathLike[str], scale: float, parts: Sequence[WallPart | Mapping[str, Any]] | None) -> list[Wall]: ...
    def profile_read(self, path: str | os.PathLike[str]) -> Profile: ...
    def profile_parse(self, name: str, data: str | bytes) -> Profile: ...
    def grains_read(self, path: str | os.PathLike[str]) -> Grains: ...
    def grains_parse(self, name: str, data: str | bytes) -> Grains: ...
    def grains(self, material: Material | None, grains: Grains | Mapping[str, Any]) -> None: ...
    def vtp_write(self, path: str | os.PathLike[str]) -> None: ...
    def vtk_write(self, path: str | os.PathLike[str]) -> None: ...
    def xyz_write(self, path: str | os.PathLike[str]) -> None: ...
    def contacts_vtp_write(self, path: str | os.PathLike[str]) -> None: ...
    def walls_vtp_write(self, path: str | os.PathLike[str], z0: float, z1: float) -> None: ...
    def surfaces_vtp_write(self, path: str | os.PathLike[str]) -> None: ...
    def bodies_csv_write(self, path: str | os.PathLike[str]) -> None: ...
    def contacts_csv_write(self, path: str | os.PathLike[str]) -> None: ...
    def replay(self, path: str | os.PathLike[str], *, title: str | None = ..., number: str | None = ..., number_fn: Callable[..., Any] | None = ..., user: Any = ..., resolution: float = ..., interval: float = ..., contacts: int = ...) -> Replay: ...
    def checkpoint_write(self, path: str | os.PathLike[str]) -> None: ...
    def checkpoint_read(self, path: str | os.PathLike[str]) -> None: ...
    def checkpoint_read_changed(self, path: str | os.PathLike[str], allowed: str) -> None: ...
    @property
    def checkpoint_changes(self) -> str: ...
    def output(self, *, kind: OutputKind | str | int = ..., path: str | os.PathLike[str] | None = ..., interval: float = ..., start: float = ..., end: float = ..., wall: Wall | None = ..., columns: str | Sequence[str] | None = ..., values: Callable[..., Any] | None = ..., function: Callable[..., Any] | None = ..., user: Any = ..., mixing: MixingDesc | Mapping[str, Any] | None = ..., field: Field | None = ..., z0: float = ..., z1: float = ..., outlet: Outlet | None = ...) -> Output: ...
    def output_every(self, kind: OutputKind | str | int, path: str | os.PathLike[str], interval: float) -> Output: ...
    def slabs(self, *, axis: int = ..., count: int = ..., first: int = ..., local: int = ..., transport: Transport | Mapping[str, Any] | None = ..., balance: float = ..., balance_interval: int = ...) -> Slabs: ...
    def effects(self, budget: float = ...) -> list[Effect]: ...
    def effects_print(self, budget: float = ..., out: TextIO | None = ...) -> None: ...
    def report(self, out: TextIO | None = ...) -> None: ...

class Replay(ReplayBase):
    def frame_write(self) -> None: ...
    def value_set(self, name: str, value: float) -> None: ...

class Slabs(SlabsBase):
    def step(self, steps: int) -> None: ...
    def collect(self, world: World) -> None: ...
    def loads_reset(self) -> None: ...
    @property
    def error(self) -> str: ...
    def slab(self, index: int) -> Slab: ...
    @property
    def counters(self) -> SlabsCounters: ...

def quat_about(axis: Vec3 | _Numbers, angle: float) -> Quat: ...
def quat_multiply(a: Quat | _Numbers, b: Quat | _Numbers) -> Quat: ...
def quat_rotate(q: Quat | _Numbers, v: Vec3 | _Numbers) -> Vec3: ...
def quat_unrotate(q: Quat | _Numbers, v: Vec3 | _Numbers) -> Vec3: ...
def memory_rotate(c: Contact | Mapping[str, Any], v: Vec3 | _Numbers) -> Vec3: ...
def law_load(c: Contact | Mapping[str, Any], f: ContactForce | Mapping[str, Any], hold: float) -> None: ...
def law_hertz(c: Contact | Mapping[str, Any], memory: _Array, f: ContactForce | Mapping[str, Any]) -> None: ...
def law_linear(c: Contact | Mapping[str, Any], memory: _Array, f: ContactForce | Mapping[str, Any]) -> None: ...
def law_hysteretic(c: Contact | Mapping[str, Any], memory: _Array, f: ContactForce | Mapping[str, Any]) -> None: ...
def law_viscous(c: Contact | Mapping[str, Any], memory: _Array, f: ContactForce | Mapping[str, Any]) -> None: ...
def law_step(c: Contact | Mapping[str, Any], memory: _Array, f: ContactForce | Mapping[str, Any]) -> None: ...
def law_spring(c: Contact | Mapping[str, Any], memory: _Array, f: ContactForce | Mapping[str, Any]) -> None: ...
def law_mindlin(c: Contact | Mapping[str, Any], memory: _Array, f: ContactForce | Mapping[str, Any]) -> None: ...
def law_mindlin_rescaled(c: Contact | Mapping[str, Any], memory: _Array, f: ContactForce | Mapping[str, Any]) -> None: ...
def law_roll_step(c: Contact | Mapping[str, Any], memory: _Array, f: ContactForce | Mapping[str, Any]) -> None: ...
def law_roll_constant(c: Contact | Mapping[str, Any], memory: _Array, f: ContactForce | Mapping[str, Any]) -> None: ...
def law_roll_epsd(c: Contact | Mapping[str, Any], memory: _Array, f: ContactForce | Mapping[str, Any]) -> None: ...
def law_twist(c: Contact | Mapping[str, Any], memory: _Array, f: ContactForce | Mapping[str, Any]) -> None: ...
def result_name(result: Result | str | int) -> str: ...
def ellipsoids_contact(a: Ellipsoid | Mapping[str, Any], b: Ellipsoid | Mapping[str, Any], lambda_: float = ...) -> EllipsoidContact: ...
def trials_print(trials: Trials | Mapping[str, Any], out: TextIO | None = ...) -> None: ...
