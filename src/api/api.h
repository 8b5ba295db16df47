/* ---------------------------------------------------------------------------------------------
   >>api
   Types and constants that all other declarations use, and everything that a contact law needs: the
   contact it sees, the force it returns, and the built-in laws, which it may call.
   --------------------------------------------------------------------------------------------- */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#define DEM_VERSION_MAJOR 0
#define DEM_VERSION_MINOR 1
#define DEM_VERSION_PATCH 0
#define DEM_VERSION (DEM_VERSION_MAJOR*10000 + DEM_VERSION_MINOR*100 + DEM_VERSION_PATCH)

/* The type of the state: double or float. Times and sums are always double. */
#ifndef DEM_REAL
#define DEM_REAL double
#endif
typedef DEM_REAL dem_real;
/* A constant in the precision of dem_real: DEM_R(0.1). */
#define DEM_R(x) ((dem_real)(x))

#if defined(DEM_STATIC) && defined(__GNUC__)
#define DEM_API static __attribute__((unused))
#elif defined(DEM_STATIC)
#define DEM_API static
#else
#define DEM_API extern
#endif

/* Forces inlining of contact laws (also the one named by DEM_LAW) and of small vector functions:
   passing vectors through memory costs more than their arithmetic. Without optimisation it is plain
   `inline`, because forced inlining would only make the code larger. */
#if defined(__GNUC__) && defined(__OPTIMIZE__) && !defined(__TINYC__)
#define DEM_INLINE static inline __attribute__((always_inline))
#else
#define DEM_INLINE static inline
#endif

/* The value of a desc whose members are all zero. */
#ifdef __cplusplus
#define DEM_ZERO {}
#else
#define DEM_ZERO {0}
#endif

/* Switches: what a program does not need may be left out of it (manual, 14). A function that is
   switched off is not declared. No struct changes, so files with other switches may be linked. */
#ifdef DEM_CORE
#undef DEM_NO_FILES
#define DEM_NO_FILES
#undef DEM_NO_REPORTS
#define DEM_NO_REPORTS
#undef DEM_NO_SLABS
#define DEM_NO_SLABS
#undef DEM_NO_IMPULSES
#define DEM_NO_IMPULSES
#undef DEM_NO_POLYHEDRA
#define DEM_NO_POLYHEDRA
#endif
#if defined(DEM_NO_FILES) && !defined(DEM_NO_REPLAY)
#define DEM_NO_REPLAY                   /* writes a file */
#endif
#if (defined(DEM_NO_FILES) || defined(DEM_NO_REPORTS)) && !defined(DEM_NO_TRIALS)
#define DEM_NO_TRIALS                   /* reports on copies, which are made as checkpoints are */
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- results ---- */
/* The result of a call. dem_world_error_get returns the message, dem_result_name_get the name. */
typedef enum dem_result {
    DEM_OK = 0,
    /* a value is out of range, an id is invalid, or a call is not allowed here */
    DEM_ERROR_ARGUMENT,
    /* the allocator returned null */
    DEM_ERROR_MEMORY,
    /* a file cannot be opened, read, written or renamed */
    DEM_ERROR_FILE,
    /* the contents of a file are damaged, or of another format, version or scene */
    DEM_ERROR_FORMAT,
    /* the time step is too large for a contact, a spin, or the speed of a body or wall */
    DEM_ERROR_TIME_STEP,
    /* a state or force is not finite, an overlap is larger than a radius, or a motion gives an
       impossible pose */
    DEM_ERROR_UNSTABLE,
    /* a function of yours stopped the run, dem_world_settle ran out of time, or a step with
       impulses exceeded the tolerance (unsolved_stops) */
    DEM_ERROR_STOPPED
} dem_result;

/* ---- vectors, boxes, poses ---- */
typedef struct dem_vec3 { dem_real x, y, z; } dem_vec3;
/* An axis-aligned box from corner lo to corner hi. */
typedef struct dem_box { dem_vec3 lo, hi; } dem_box;
/* A unit quaternion that rotates vectors from the frame of a body into the world frame. w is the
   scalar part. */
typedef struct dem_quat { dem_real w, x, y, z; } dem_quat;

/* Position and motion of a rigid wall. A point with wall coordinates p is at position + rotation p
   in the world frame. */
typedef struct dem_pose {
    dem_vec3 position;    /* m, of the origin of the wall's frame */
    dem_real rotation[9]; /* 3 x 3 rotation matrix, row by row */
    dem_vec3 velocity;    /* m/s, of `position` */
    dem_vec3 spin;        /* rad/s, about `position` */
} dem_pose;

/* The vector (x, y, z). */
DEM_INLINE dem_vec3 dem_vec3_make(dem_real x, dem_real y, dem_real z) {
    dem_vec3 v; v.x = x; v.y = y; v.z = z; return v;
}
/* The box from (x0, y0, z0) to (x1, y1, z1). */
DEM_INLINE dem_box dem_box_make(dem_real x0, dem_real y0, dem_real z0, dem_real x1, dem_real y1,
                                dem_real z1) {
    dem_box b; b.lo = dem_vec3_make(x0, y0, z0); b.hi = dem_vec3_make(x1, y1, z1); return b;
}

/* The quaternion w + x i + y j + z k; it is not normalised. (1, 0, 0, 0) is no rotation. */
DEM_INLINE dem_quat dem_quat_make(dem_real w, dem_real x, dem_real y, dem_real z) {
    dem_quat q; q.w = w; q.x = x; q.y = y; q.z = z; return q;
}
/* The right-handed rotation by `angle` (rad) about `axis` (any length except 0). */
DEM_API dem_quat dem_quat_about(dem_vec3 axis, dem_real angle);
/* The product a b: the rotation b followed by the rotation a. */
DEM_INLINE dem_quat dem_quat_multiply(dem_quat a, dem_quat b) {
    return dem_quat_make(a.w*b.w - a.x*b.x - a.y*b.y - a.z*b.z,
                         a.w*b.x + a.x*b.w + a.y*b.z - a.z*b.y,
                         a.w*b.y - a.x*b.z + a.y*b.w + a.z*b.x,
                         a.w*b.z + a.x*b.y - a.y*b.x + a.z*b.w);
}
/* Rotates v from the frame of a body into the world frame. q must have unit length. */
DEM_INLINE dem_vec3 dem_quat_rotate(dem_quat q, dem_vec3 v) {
    const dem_real x = 2*(q.y*v.z - q.z*v.y), y = 2*(q.z*v.x - q.x*v.z), z = 2*(q.x*v.y - q.y*v.x);
    return dem_vec3_make(v.x + q.w*x + q.y*z - q.z*y, v.y + q.w*y + q.z*x - q.x*z,
                         v.z + q.w*z + q.x*y - q.y*x);
}
/* Rotates v from the world frame into the frame of a body. q must have unit length. */
DEM_INLINE dem_vec3 dem_quat_unrotate(dem_quat q, dem_vec3 v) {
    return dem_quat_rotate(dem_quat_make(q.w, -q.x, -q.y, -q.z), v);
}

/* ---- ids ----
   An id names an object of one world. An all-zero id is the null id: it names nothing. */
typedef struct dem_material { int32_t id; } dem_material;    /* counts from 1 */
/* Counts from 1. A wall added after a removal gets an id of a later generation, such as 262145:
   ids are names, not indices. */
typedef struct dem_wall { int32_t id; } dem_wall;
typedef struct dem_field { int32_t id; } dem_field;          /* counts from 1 */
typedef struct dem_group { int32_t id; } dem_group;          /* counts from 1 in desc.groups */
typedef struct dem_shape { int32_t id; } dem_shape;          /* counts from 1; 0 means a sphere */
/* slot counts from 1. A later body in the same slot has another generation. */
typedef struct dem_body { uint32_t slot, generation; } dem_body;

/* A world: everything that one simulation consists of. */
typedef struct dem_world dem_world;

/* ---- choices: the constants of dem_world_desc ---- */
/* The law of the normal force. Here delta is the overlap, m, and v the closing speed, m/s. */
typedef enum dem_normal_law {
    /* F = kn delta^(3/2) + cn delta^(1/4) v  [HER82, TSU92] */
    DEM_NORMAL_HERTZ = 0,
    /* F = kn delta + cn v. kn is given, or follows from Young's modulus and an impact speed. */
    DEM_NORMAL_LINEAR,
    /* [ALK07] eq 2.47: the contact loads along kn delta, unloads and reloads with slope kun, and
       attracts by at most kad delta. It needs no dashpot. */
    DEM_NORMAL_HYSTERETIC
} dem_normal_law;
#define DEM_LAW_COEFFICIENTS(X) \
    X(stiffness_adhesion, kad, "N/m") \
    /* the last */
/* The list above has the coefficients that only one normal law uses: X(property, coefficient, unit
   of the property). The property is a field of dem_material_desc and dem_pair, >= 0, and mixed by
   the geometric mean. The coefficient is a field of dem_contact and dem_coefficients. It is 0 under
   laws that do not use it. */
#define DEM_PROPERTY_FIELD(PROPERTY, COEFFICIENT, UNIT) dem_real PROPERTY;
#define DEM_COEFFICIENT_FIELD(PROPERTY, COEFFICIENT, UNIT) dem_real COEFFICIENT;

/* The law of friction. Every law except DEM_TANGENT_NONE limits the force by Coulomb's law. */
typedef enum dem_tangent_law {
    /* DEM_TANGENT_SPRING if any pair has friction, otherwise DEM_TANGENT_NONE */
    DEM_TANGENT_AUTO = 0,
    /* no tangential force */
    DEM_TANGENT_NONE,
    /* -ct v_t, without history */
    DEM_TANGENT_VISCOUS,
    /* [MIL]: -kt (v_t dt) - ct v_t, without history */
    DEM_TANGENT_STEP,
    /* [CS79]: -kt xi - ct v_t, where xi is the integral of v_t over the contact */
    DEM_TANGENT_SPRING,
    /* [DIR05]: the force grows by increments, with kt of the overlap in the middle of the step */
    DEM_TANGENT_MINDLIN,
    /* [THO13]: as DEM_TANGENT_MINDLIN, but the force is scaled down with kt during unloading */
    DEM_TANGENT_MINDLIN_RESCALED
} dem_tangent_law;

/* The law of rolling resistance. */
typedef enum dem_rolling_law {
    /* DEM_ROLLING_EPSD if any pair has rolling friction, otherwise DEM_ROLLING_NONE */
    DEM_ROLLING_AUTO = 0,
    /* no rolling resistance */
    DEM_ROLLING_NONE,
    /* [MIL] section 4.5: mu_r R* min(Fn, |w|), with the dimensions as printed there */
    DEM_ROLLING_STEP,
    /* [ZHO99]: a moment mu_r R* Fn against the relative spin; at rest any moment up to that */
    DEM_ROLLING_CONSTANT,
    /* [AI11]: an elastic-plastic spring and a dashpot, with history */
    DEM_ROLLING_EPSD
} dem_rolling_law;

/* The dashpot at the end of a contact, where it would attract. */
typedef enum dem_tension {
    /* The dashpot may attract; the restitution is the given one. */
    DEM_TENSION_ALLOWED = 0,
    /* The contact ends at zero force. The restitution becomes higher than the given one: 0.66 gives
       about 0.69 [SP07]. */
    DEM_TENSION_CLIPPED,
    /* The contact ends at zero force and the damping is raised so that the restitution is the given
       one: the closed form of [SP07] solved for the dashpot, as in [THO13]. */
    DEM_TENSION_COMPENSATED
} dem_tension;

/* The load L of Coulomb's limit mu L. The choices differ where the normal force has a dashpot. */
typedef enum dem_load {
    /* L is the whole normal force, or 0 while it attracts: Coulomb's law at every instant. In an
       impact that slides throughout, the impulse of friction is larger than mu times the normal
       impulse: by 9 % at a restitution of 0.25, by 14 % at 0.1. */
    DEM_LOAD_REPULSIVE = 0,
    /* L is the elastic part of the normal force. In an impact that slides throughout, the impulse
       of friction is mu times the normal impulse for any restitution, as for rigid bodies. */
    DEM_LOAD_ELASTIC,
    /* L is the magnitude of the normal force, as in LAMMPS, LIGGGHTS and MercuryDPM. The excess is
       18 % at a restitution of 0.25 and 28 % at 0.1. */
    DEM_LOAD_MAGNITUDE
} dem_load;

/* How the tangential spring and dashpot share Coulomb's limit while a contact slides. The force is
   the same while a contact sticks and while it slides steadily. In between, the force differs, and
   so does the energy that the spring holds. */
typedef enum dem_slider {
    /* Spring and dashpot act in parallel behind one slider. This never creates energy. */
    DEM_SLIDER_PARALLEL = 0,
    /* The spring alone takes the whole limit, as in [THO13] and its published impacts. Creates up
       to 3 % of an impact's energy at a restitution of 0.5 and 15 % at 0.1. */
    DEM_SLIDER_SPRING,
    /* The spring takes what the dashpot leaves of the limit, as in LAMMPS, MercuryDPM and MFiX. It
       stores energy that no slip supplied. Under Hertz's law with a dashpot the result depends on
       the time step: an oblique impact leaves at 0.247 of its speed at t_c/100, and at 0.221 at
       t_c/25600 and below. */
    DEM_SLIDER_REMAINDER
} dem_slider;

/* Conventions for effective quantities and overlaps. */
typedef enum dem_convention {
    /* E*, G*, R*, m* and the overlap as in the contact literature */
    DEM_CONVENTION_STANDARD = 0,
    /* [MIL] Fig 5.23: E* = E, 8 G, half overlaps between grains, R/2 and m/2 against walls. Only
       for reproducing that thesis. */
    DEM_CONVENTION_MILL
} dem_convention;

/* The scheme of time integration with springs. Impulses have their own, of second order. */
typedef enum dem_integrator {
    /* second order; the default */
    DEM_INTEGRATOR_VELOCITY_VERLET = 0,
    /* first order, gains energy; the scheme named in the text of [MIL] */
    DEM_INTEGRATOR_FORWARD_EULER,
    /* first order, bounded error of energy */
    DEM_INTEGRATOR_SYMPLECTIC_EULER,
    /* the original Verlet scheme: x(t + dt) = 2 x(t) - x(t - dt) + a dt^2 */
    DEM_INTEGRATOR_POSITION_VERLET,
    /* velocities at half steps; the same trajectory as velocity Verlet */
    DEM_INTEGRATOR_LEAPFROG
} dem_integrator;

/* How contacts respond. */
typedef enum dem_response {
    /* Soft contacts: forces grow with the overlap, by the laws above. A time step is a fiftieth of
       a contact time. */
    DEM_RESPONSE_SPRINGS = 0,
    /* Rigid contacts (non-smooth dynamics, >>impulses): impulses prevent overlap. The
       laws above do not act; restitution, friction and static friction of the materials do, and
       cohesion and compliance of pairs. Rolling and spinning friction need Gauss-Seidel; with
       another solver a step fails. A time step is as long as the flow allows, 1e-3 s for grains of
       some millimetres. */
    DEM_RESPONSE_IMPULSES
} dem_response;
/* The friction law of impulses. */
typedef enum dem_cone {
    /* Coulomb's law: sliding contacts stay closed. */
    DEM_CONE_COULOMB = 0,
    /* The convex relaxation of [TAS10]: a contact that slides at speed v opens by mu v dt. */
    DEM_CONE_CONVEX
} dem_cone;
/* The iterative solver for impulses (>>solvers). The page docs/impulses.md compares them. */
typedef enum dem_solver {
    /* one contact after another: robust, and needs the fewest sweeps; the default */
    DEM_SOLVER_GAUSS_SEIDEL = 0,
    /* all contacts at once; for comparison */
    DEM_SOLVER_JACOBI,
    /* accelerated projected gradient descent [MAZ15]; for residuals far below the default */
    DEM_SOLVER_APGD,
    /* projected gradients with Barzilai-Borwein steps [HEY13]; for residuals far below the default
       */
    DEM_SOLVER_SPECTRAL
} dem_solver;

/* How the orientations of bodies other than spheres are integrated. Every choice conserves angular
   momentum to round-off in free flight and is of second order in dt under torques. docs/shapes.md
   compares errors and costs. */
typedef enum dem_rotation {
    /* [SPI24] with conserved angular momentum; the most accurate and the cheapest */
    DEM_ROTATION_SPIRAL = 0,
    /* [FIN92], as used by [RUB15]; gains energy, for comparison */
    DEM_ROTATION_FINCHAM,
    /* symplectic splitting [DLM97]; the smallest change of energy, the most expensive */
    DEM_ROTATION_NO_SQUISH
} dem_rotation;

/* The overlap of two ellipsoids. Scaled about their centres by W0, the two touch in one point. hA
   and hB are their support heights along the normal there. */
typedef enum dem_overlap {
    /* l (1 - W0), where l is the sum of the radii of spheres of equal volume. The force is the
       gradient of an energy, so built-in laws conserve energy. */
    DEM_OVERLAP_CONSERVATIVE = 0,
    /* [RUB15] section 3.2: the length inside both ellipsoids of a line through the contact point,
       there V2 V3 (docs/theory_surfaces.md) */
    DEM_OVERLAP_CHORD,
    /* (hA + hB)(1 - W0), along the normal */
    DEM_OVERLAP_NORMAL
} dem_overlap;

/* How several contacts between the spheres of two bodies count, if one body is a cluster. */
typedef enum dem_cluster_contacts {
    /* Contacts with similar normals act as one contact. Stiffness and restitution do not depend on
       the number of spheres that touch [BER23]. */
    DEM_CLUSTER_CONTACTS_MERGED = 0,
    /* Each is a contact of its own. The stiffness grows with their number. */
    DEM_CLUSTER_CONTACTS_SEPARATE
} dem_cluster_contacts;

/* The broad phase of contact detection. All choices find the same contacts. */
typedef enum dem_search {
    /* a grid, or a hierarchical grid if radii differ enough; dem_world_report prints the choice */
    DEM_SEARCH_AUTO = 0,
    /* every pair; the reference for the others */
    DEM_SEARCH_ALL_PAIRS,
    /* a uniform grid of cells */
    DEM_SEARCH_GRID,
    /* a linked linear list [ALK07] section 2.3.2: sorted ends of boxes on three axes */
    DEM_SEARCH_LINKED_LIST,
    /* a hierarchical grid [OGA12]: each class of radii has its own cells */
    DEM_SEARCH_HIERARCHICAL,
    /* bins [MAZ11]: each body is entered in every bin that its box touches */
    DEM_SEARCH_BINS
} dem_search;

/* The faces of the domain box, per axis: what they do to a body that leaves. */
typedef enum dem_boundary {
    /* nothing: bodies may leave */
    DEM_BOUNDARY_OPEN = 0,
    /* a body that leaves on one side enters on the other */
    DEM_BOUNDARY_PERIODIC,
    /* A body whose centre leaves is removed in that step and counted as left. Each removal rebuilds
       the neighbour list, so an outlet is cheaper where many bodies leave one by one. */
    DEM_BOUNDARY_OUTFLOW
} dem_boundary;

/* ---- private maths for the laws below; it may change ---- */
/* True if dem_real is float. The compiler evaluates it. */
#define DEMI_SINGLE (sizeof(dem_real) == sizeof(float))
#define DEMI_SQRT(x) (DEMI_SINGLE ? (dem_real)sqrtf((float)(x)) : (dem_real)sqrt((double)(x)))
#define DEMI_ABS(x) (DEMI_SINGLE ? (dem_real)fabsf((float)(x)) : (dem_real)fabs((double)(x)))
/* Added to a denominator that may be 0. */
#define DEMI_TINY (DEMI_SINGLE ? DEM_R(1e-30) : DEM_R(1e-200))
#if defined(__GNUC__) && !defined(__TINYC__) && !defined(__cplusplus)
extern double (sqrt)(double) __attribute__((const));  /* "const": does not set errno, so roots */
extern float (sqrtf)(float) __attribute__((const));  /* can be vectorised without -fno-math-errno */
#endif
DEM_INLINE dem_vec3 demi_v(dem_real x, dem_real y, dem_real z) { return dem_vec3_make(x, y, z); }
DEM_INLINE dem_vec3 demi_at(const dem_real *p) { return dem_vec3_make(p[0], p[1], p[2]); }
DEM_INLINE dem_vec3 demi_add(dem_vec3 a, dem_vec3 b) { return demi_v(a.x + b.x, a.y + b.y, a.z +
    b.z); }
DEM_INLINE dem_vec3 demi_sub(dem_vec3 a, dem_vec3 b) { return demi_v(a.x - b.x, a.y - b.y, a.z -
    b.z); }
DEM_INLINE dem_vec3 demi_scale(dem_vec3 a, dem_real s) { return demi_v(a.x*s, a.y*s, a.z*s); }
DEM_INLINE dem_vec3 demi_product(dem_vec3 a, dem_vec3 b) {
    return demi_v(a.x*b.x, a.y*b.y, a.z*b.z);
}
DEM_INLINE dem_real demi_dot(dem_vec3 a, dem_vec3 b) { return a.x*b.x + a.y*b.y + a.z*b.z; }
DEM_INLINE dem_vec3 demi_cross(dem_vec3 a, dem_vec3 b) {
    return demi_v(a.y*b.z - a.z*b.y, a.z*b.x - a.x*b.z, a.x*b.y - a.y*b.x);
}
DEM_INLINE dem_real demi_length(dem_vec3 a) { return DEMI_SQRT(demi_dot(a, a)); }
DEM_INLINE void demi_put(dem_real *p, dem_vec3 v) { p[0] = v.x; p[1] = v.y; p[2] = v.z; }

/* ---- contacts and user-defined laws ---- */

enum { DEM_GROUPS = 32 };         /* largest number of groups: desc.groups */
enum { DEM_BODY_REALS = 8 };      /* largest number of user-defined reals per body: body_reals */
enum { DEM_LAW_MEMORY = 16 };     /* largest contact history of a user-defined law: law_memory */

/* The two bodies of a contact, for laws that request them by desc.law_who = 1. */
typedef struct dem_contact_who {
    dem_body a, b;                /* b is the null id at a wall; c->wall is then the wall's id */
    /* m, of the spheres that touch (member spheres of clusters); of other shapes the bounding
       radius; 0 for a wall, except a wall of grains: the radius of its grains */
    dem_real radius_a, radius_b;
    dem_real mass_a, mass_b;      /* kg, of the whole bodies; 0 for a wall */
    dem_vec3 point;               /* m, contact point in the world frame; at a wall: on the surface
                                     of a */
    double time;                  /* s, at the end of the step */
    /* present values of the user-defined numbers of a and of b or the wall, in the order of
       desc.body_reals; null if desc.body_reals names none */
    const dem_real *reals_a, *reals_b;
    /* The law adds the rates of change of these numbers here, per s. They are 0 when the law is
       called; the pointers are null if reals_a is. If a contact has several contact points (member
       spheres of clusters, facets), dem.h multiplies the rates of each by its weight */
    dem_real *rate_a, *rate_b;
} dem_contact_who;
/* All that a contact law sees. Velocities are those of body a relative to body b, or to the surface
   of the wall, at the full step: use them for dashpots and friction. Displacements in the contact
   history grow by slip_step dt, the displacement of the step just taken, so that springs conserve
   energy as well as the integrator does. */
typedef struct dem_contact {
    dem_real overlap;        /* m, > 0 in contact; < 0 across a gap (laws with a range only) */
    dem_real range;          /* m, gap up to which the law is called here (desc.law_range); or 0 */
    dem_real closing_speed;  /* m/s, positive while the two approach */
    dem_vec3 normal;         /* unit vector from a to b */
    dem_vec3 slip;           /* m/s, tangential velocity at the contact point, rotation included */
    dem_vec3 spin;           /* rad/s, spin of a minus spin of b */
    dem_vec3 slip_step;      /* m/s, mean of `slip` over the step just taken */
    dem_vec3 spin_step;      /* rad/s, mean of `spin` over the step just taken */
    dem_vec3 normal_rate;    /* 1/s, mean rate of change of the normal in that step */
    dem_real twist;          /* rad/s, mean rotation of the contact plane about the normal */
    dem_real r_eff;          /* m, 1/(1/Ra + 1/Rb), at a wall Ra; other shapes: equivalent radii */
    /* kg, 1/(1/ma + 1/mb), at a wall ma; with bodies other than spheres the mass that a normal
       force at the contact point accelerates, rotation included */
    dem_real m_eff;
    dem_real dt;             /* s, the time step. 0: leave the contact history unchanged */
    /* At ellipsoids, polyhedra and polygons kn, cn, kun and kad are multiplied by s, the derivative
       of the overlap with respect to the approach, and the ledger divides `elastic` and `sag` by s.
       The ledger closes if the normal force is proportional to these; with other forces, for
       example a constant attraction, only while s is constant: not at corners and edges. */
    dem_real kn, cn;  /* built-in law: N/m^(3/2), N s/m^(5/4) (Hertz) or N/m, N s/m (others) */
    dem_real kt, ct;  /* built-in law: N/m^(3/2), N s/m^(5/4) (Hertz) or N/m, N s/m (others) */
    dem_real kun;            /* N/m, unloading of the hysteretic law; otherwise 0 */
    /* of the pair of materials */
    dem_real friction, friction_static, rolling_friction, spinning_friction;
    dem_real sliding;        /* force->sliding of the last step; 0 when the contact begins */
    int32_t material_a, material_b; /* ids of materials */
    int32_t wall;            /* id of the wall; 0: b is a body */
    int tension, friction_load, slider;  /* dem_tension, dem_load, dem_slider of the world desc */
    dem_contact_who who;     /* zeros unless desc.law_who is 1 */
    void *user;              /* desc.law_user */
    /* kad: coefficients of single laws */
    DEM_LAW_COEFFICIENTS(DEM_COEFFICIENT_FIELD)
} dem_contact;

/* The energies of one contact, J. Losses and work are those of the step. */
typedef struct dem_contact_energy {
    dem_real dashpot, sag;   /* lost to the normal dashpot; to hysteresis (dt 0: next step) */
    dem_real elastic;        /* stored in the normal spring now */
    dem_real shear_work;     /* work done against the tangential force */
    dem_real slide;          /* lost to sliding */
    dem_real shear_stored;   /* stored in the tangential spring now */
    dem_real roll;           /* lost to rolling resistance */
} dem_contact_energy;

/* The result of a contact law. All fields are 0 when the law is called. */
typedef struct dem_contact_force {
    dem_real normal;         /* N, positive: repulsion */
    dem_vec3 tangent;        /* N, on a at the contact point; b receives the opposite */
    dem_vec3 moment;         /* N m, on a (rolling resistance); b receives the opposite */
    /* From here to ct: what a normal law passes to the friction and rolling laws that follow it. A
       law that calls none of these may leave them at 0. */
    dem_real elastic;        /* N, the part of `normal` that the spring exerts */
    dem_real load;           /* N, >= 0: L of Coulomb's limit mu L */
    /* N/m, d(elastic)/d(overlap): at the present overlap; and at the overlap in the middle of that
       part of the step in which the two touched. Hysteretic law: kn */
    dem_real slope, slope_step;
    dem_real kt, kt_step;    /* N/m, tangential stiffness: likewise */
    dem_real ct;             /* N s/m, tangential dashpot */
    /* 1 while the contact slides, otherwise 0. The friction laws set it. If friction_static is
       larger than friction for any pair, contact history keeps it and c->sliding returns it */
    dem_real sliding;
    dem_contact_energy energy;   /* for the ledger, which cannot know what a law leaves at 0 */
} dem_contact_force;

/* A contact law: computes *force from *c. `memory` is the contact history: desc.law_memory reals.
   They are 0 when a contact begins and last as long as the two touch or, with a range, are nearer
   than the range. A law with a range decides itself when a bond or bridge begins and ends, and
   stores that in its history. If c->dt is 0, dem.h only asks for the force: leave `memory`
   unchanged. The first 3*law_vectors reals are vectors and change sign when a and b are exchanged;
   put tangential springs there, and scalars after them. A law must use nothing except its arguments
   and c->user. Several threads call it at once. */
typedef void (*dem_law_fn)(const dem_contact *c, dem_real *memory, dem_contact_force *force);
/* For laws that change user-defined numbers (law_who): bounds the time step. rates[0] receives how
   fast this contact alone makes a number of body a approach that of its partner, rates[1] the same
   for body b: 1/s, >= 0, the largest of several numbers. Both are 0 when it is called. A step is
   stable while dt times the sum over the contacts of a body is below 1.
   In *c only overlap, range, normal, r_eff, m_eff, dt, user, material_a, material_b, wall and `who`
   (without point and rates; its radii are those of bounding spheres, of a wall 0) are set;
   velocities and coefficients are 0. */
typedef void (*dem_law_rate_fn)(const dem_contact *c, dem_real *rates);

/* Rotates a tangent vector of the contact history with the contact plane over the last step: with
   the normal, and with the mean spin of the two bodies about it. The result lies in the tangent
   plane and has the length of v. Laws with a tangential spring call it first.
   Accuracy: the rotation of the normal is exact to sixth order in its angle. The rotation t about
   the normal is limited to 1 rad per step; it shortens v by a fraction of t^4/64 and never
   lengthens it: (1 - u/2)^2 + u (1 - 9 u/64)^2 <= 1 with u = t^2 <= 1. */
DEM_INLINE dem_vec3 dem_memory_rotate(const dem_contact *c, dem_vec3 v) {
    const dem_vec3 n = c->normal, r = c->normal_rate;
    const dem_real g = v.x*n.x + v.y*n.y + v.z*n.z;      /* component along the normal */
    const dem_real e = c->dt*c->dt*(r.x*r.x + r.y*r.y + r.z*r.z);  /* sin^2 of the angle */
    const dem_real h = g*c->dt*(DEM_R(0.5) + e/8);       /* 1/(1 + cos) */
    const dem_real w = c->dt*c->twist, t = w > 1 ? 1 : w < -1 ? -1 : w;   /* rad, at most 1 */
    const dem_real u = t*t, q = 1 - u/2, s = t - t*u*DEM_R(0.140625);  /* cos, sin */
    const dem_real x = v.x - g*n.x + h*r.x, y = v.y - g*n.y + h*r.y, z = v.z - g*n.z + h*r.z;
    dem_vec3 out;
    out.x = q*x + s*(n.y*z - n.z*y);
    out.y = q*y + s*(n.z*x - n.x*z);
    out.z = q*z + s*(n.x*y - n.y*x);
    return out;
}

/* ---- the built-in laws ----
   Every built-in law is a dem_law_fn, and user-defined laws may call them: first a normal law, then
   a friction law, then a rolling law. The later ones use what the normal law has stored in *f: the
   load and the stiffnesses. `memory` must point to the first real of the law's own history; the
   comments give its size (vectors first). Coefficients (kn, cn, kt, ct, ...) come with the contact.
   No law has a branch that depends on the contact, so that compilers can vectorise loops over
   contacts. docs/theory.md has the coefficients.
   tests/law/test_laws.c checks all of them: springs are of second order in the time step,
   user-defined laws that call built-in laws get the same bits, and every accepted time step is
   stable. */

/* Computes the load for friction and removes a dashpot's attraction. A normal law calls it after it
   has set f->elastic and f->normal. Without tension (CLIPPED, COMPENSATED) f->normal is raised to
   0, or to the elastic force if that attracts. The load is that of c->friction_load, at least 0;
   without tension it is always the whole normal force.
   hold: N, >= 0, adhesion that adds to the load (not with DEM_LOAD_MAGNITUDE); 0: none. */
DEM_INLINE void dem_law_load(const dem_contact *c, dem_contact_force *f, dem_real hold) {
    const int clipped = c->tension != DEM_TENSION_ALLOWED;
    const dem_real least = f->elastic < 0 ? f->elastic : 0;  /* adhesion may attract */
    const dem_real whole = (clipped || c->friction_load != DEM_LOAD_ELASTIC ? f->normal
                                                                          : f->elastic) + hold;
    const dem_real size = f->normal < 0 ? -f->normal : f->normal;
    f->load = whole > 0 ? whole : 0;
    if (!clipped && c->friction_load == DEM_LOAD_MAGNITUDE) f->load = size;
    if (clipped) f->normal = f->normal < least ? least : f->normal;
    f->energy.dashpot = (f->normal - f->elastic)*c->closing_speed*c->dt;
}
/* The fraction of the step during which the two touched (were within the range): 1 unless the
   contact began in this step. The contact history grows by the displacement in this time.
   Tests: tests/law/test_laws.c (tangential and rolling springs are integrated to second order). */
DEM_INLINE dem_real demi_law_share(const dem_contact *c) {
    const dem_real gone = c->closing_speed*c->dt;
    const dem_real in = c->range > 0 ? c->overlap + c->range : c->overlap;
    return in > gone ? 1 : in/(gone + DEMI_TINY);
}
/* m: the mean overlap of that part of the step in which the two touched: of the overlap at its
   beginning (0 if the contact began in this step) and the present one. Springs whose history grows
   with the stiffness at this overlap are of second order in dt. */
DEM_INLINE dem_real demi_law_middle(const dem_contact *c) {
    const dem_real gone = c->closing_speed*c->dt;
    return (c->overlap + (c->overlap > gone ? c->overlap - gone : 0))/2;
}

/* The normal force of elastic spheres with a dashpot:
       F = kn d^(3/2) + cn d^(1/4) v [HER82, TSU92],  d: overlap, v: closing speed.
   The tangential coefficients are kt d^(1/2) [N/m] and ct d^(1/4) [N s/m]. No contact history.
   Tests: tests/contact/test_impacts.c, tests/run/test_analytic.c. */
DEM_INLINE void dem_law_hertz(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const dem_real root = DEMI_SQRT(c->overlap), fourth = DEMI_SQRT(root);
    const dem_real middle = DEMI_SQRT(demi_law_middle(c));
    (void)memory;
    f->elastic = c->kn*root*c->overlap;
    f->normal = f->elastic + c->cn*fourth*c->closing_speed;
    f->slope = DEM_R(1.5)*(c->kn*root);
    f->slope_step = DEM_R(1.5)*(c->kn*middle);
    f->kt = c->kt*root;
    f->kt_step = c->kt*middle;
    f->ct = c->ct*fourth;
    dem_law_load(c, f, 0);
    f->energy.elastic = f->elastic*c->overlap*2/5;
}
/* The normal force of a linear spring and dashpot: F = kn d + cn v. No contact history.
   Tests: tests/contact/test_impacts.c, tests/run/test_analytic.c. */
DEM_INLINE void dem_law_linear(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    (void)memory;
    f->elastic = c->kn*c->overlap;
    f->normal = f->elastic + c->cn*c->closing_speed;
    f->slope = f->slope_step = c->kn;
    f->kt = f->kt_step = c->kt;
    f->ct = c->ct;
    dem_law_load(c, f, 0);
    f->energy.elastic = f->elastic*c->overlap/2;
}
/* The normal force of a plastic, possibly sticky contact [ALK07] eq 2.41 to 2.49:
       F = kun d - (kun - kn) D + cn v,   D: depth of the plastic deformation, m
       loading                    d = D, so that F = kn d
       unloading and reloading    slope kun; F = 0 at d0 = (1 - kn/kun) D  [eq 2.44]
       adhesion                   F = -kad d. D shrinks with d here, so that reloading (slope kun)
                                  returns to kn d at the D that belongs to this point
   After each step D is the larger of D and d, but at most d (kun + kad)/(kun - kn). Unloading and
   adhesion join at d_ad = (kun - kn) D/(kun + kad) = (1 - e^2) kn D/(kn + kad e^2), e^2 = kn/kun.
   Differences from [ALK07]: kad is a magnitude here. It defines kad as a negative slope; with that
   its eq 2.48 and 2.49 have the wrong sign, and its text calls d_ad both a deformation and a force.
   The load of friction is F + kad d, which is 0 on the adhesion line. [ALK07] takes |F|, which is 0
   where F is 0 and large where the two are pulled apart.
   Energy: the contact stores F^2/(2 kun). A change of D dissipates F (1 - kn/kun) dD, summed
   exactly along both lines. Motion along the slope kun loses nothing, so that a grain at rest
   oscillates there unless the pair has normal_damping (cn).
   kun must be > 0. Without DEM_NORMAL_HYSTERETIC a user-defined law sets it in a copy of *c.
   Contact history: 1 real, D [m]. Tests: tests/law/test_hysteresis.c. */
DEM_INLINE void dem_law_hysteretic(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const dem_real kn = c->kn, kun = c->kun, kad = c->kad, soft = kun - kn, before = memory[0];
    const dem_real loaded = c->overlap > before ? c->overlap : before;
    const dem_real most = c->overlap*(kun + kad)/(soft + DEMI_TINY);
    const dem_real depth = most < loaded ? most : loaded;
    if (c->dt > 0) memory[0] = depth;
    f->elastic = kun*c->overlap - soft*depth;
    f->normal = f->elastic + c->cn*c->closing_speed;
    f->slope = f->slope_step = kn;
    f->kt = f->kt_step = c->kt;
    f->ct = c->ct;
    dem_law_load(c, f, kad*c->overlap);
    f->energy.elastic = f->elastic*f->elastic/(2*kun);
    f->energy.sag = soft/(2*kun)*(kn*(loaded*loaded - before*before) +
                                  kad*soft/(kun + kad)*(loaded*loaded - depth*depth));
}

/* Limits a trial force t (N) by Coulomb's law and stores it in f->tangent. A contact that holds
   begins to slide when |t| exceeds friction_static times the load. It then slides at `friction`
   times the load. It holds again when |t| is within that lower limit and its slip has stopped or
   reversed, so that the slip no longer stretches the spring: the force `spring` of the spring (N, 0
   if there is none) no longer opposes the slip.
   Returns the fraction of t that remains. Without the state of sliding the mean force of a slow
   slide would depend on dt: (friction + friction_static)/2 times the load as dt tends to 0.
   Tests: tests/law/test_friction.c (steady slide). */
DEM_INLINE dem_real demi_law_cap(const dem_contact *c, dem_contact_force *f, dem_vec3 t,
                                 dem_vec3 spring) {
    const dem_real size = DEMI_SQRT(demi_dot(t, t)), cap = f->load*c->friction;
    const dem_real most = c->sliding > 0 ? cap : f->load*c->friction_static;
    const dem_real onward = demi_dot(spring, c->slip) < 0 ? c->sliding : 0;
    dem_real cut = size > most ? size : cap;
    cut = (cap + DEMI_TINY)/(cut + DEMI_TINY);
    f->sliding = c->dt > 0 ? size > most ? DEM_R(1) : onward : c->sliding;
    f->tangent = demi_scale(t, cut);
    f->energy.shear_work = -demi_dot(f->tangent, c->slip)*c->dt;
    return cut;
}
/* Friction by a dashpot of ct (N s/m) alone: -ct v_t, limited by Coulomb's law. */
DEM_INLINE void demi_law_dashpot(const dem_contact *c, dem_contact_force *f, dem_real ct) {
    const dem_vec3 v = c->slip;
    const dem_real cut = demi_law_cap(c, f, demi_v(-ct*v.x, -ct*v.y, -ct*v.z), demi_v(0, 0, 0));
    f->energy.slide = cut < 1 ? f->energy.shear_work : 0;
}
/* Friction of a dashpot: -ct v_t, limited by Coulomb's law; [MIL] 4.3. No contact history, so that
   contacts creep under a tangential load. Tests: tests/law/test_friction.c. */
DEM_INLINE void dem_law_viscous(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    (void)memory;
    demi_law_dashpot(c, f, f->ct);
}
/* Friction of a spring that is stretched for one step only, and a dashpot: -kt (v_t dt) - ct v_t,
   limited by Coulomb's law; [MIL] 4.2. No contact history. Tests: tests/law/test_friction.c,
   tests/run/test_analytic.c. */
DEM_INLINE void dem_law_step(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    (void)memory;
    demi_law_dashpot(c, f, f->kt*c->dt + f->ct);
}
/* Returns by how much the tangential spring is shortened (m) when Coulomb's limit leaves `cut` t of
   the trial force t. It gives up this part of the removed force (1 - cut) t, by c->slider:
       PARALLEL    kt dt/(kt dt + ct) of it: spring and dashpot together then exert the limit
       REMAINDER   all of it: the spring then exerts what the dashpot leaves of the limit
       SPRING      all of it and the force of the dashpot: the spring alone then exerts the limit.
                   The energy of the dashpot's part comes from nowhere
   Stores the energy lost to sliding. */
DEM_INLINE dem_vec3 demi_law_give(const dem_contact *c, dem_contact_force *f, dem_vec3 t,
                                  dem_real cut) {
    const dem_real shared = (1 - cut)*c->dt/(f->kt*c->dt + f->ct + DEMI_TINY);
    const dem_real all = (c->dt > 0 ? 1 - cut : 0)/(f->kt + DEMI_TINY);      /* m/N */
    dem_vec3 lost = demi_scale(t, c->slider == DEM_SLIDER_PARALLEL ? shared : all);
    if (c->slider == DEM_SLIDER_SPRING)
        lost = demi_add(lost, demi_scale(c->slip, c->dt > 0 && cut < 1 ? f->ct/(f->kt + DEMI_TINY)
                                                  : 0));
    f->energy.slide = cut*demi_dot(t, lost);
    return lost;
}
/* Friction of a spring and a dashpot [CS79]: -kt s - ct v_t, limited by Coulomb's law, where s is
   the tangential displacement since the contact began, rotated with the contact plane. With Hertz's
   law kt follows the present overlap. Contact history: 3 reals, the vector s [m].
   Tests: tests/contact/test_impacts.c (oblique impacts), tests/law/test_friction.c,
   tests/law/test_laws.c. */
DEM_INLINE void dem_law_spring(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const dem_vec3 v = c->slip;
    const dem_real kt = f->kt, ct = f->ct;
    dem_vec3 s = dem_memory_rotate(c, demi_at(memory)), t;
    dem_real cut;
    s = demi_add(s, demi_scale(c->slip_step, demi_law_share(c)*c->dt));
    t = demi_v(-kt*s.x - ct*v.x, -kt*s.y - ct*v.y, -kt*s.z - ct*v.z);
    cut = demi_law_cap(c, f, t, demi_scale(s, -kt));
    s = demi_add(s, demi_law_give(c, f, t, cut));
    demi_put(memory, s);
    f->energy.shear_stored = kt*demi_dot(s, s)/2;
}
/* Friction by increments of force, for the two laws below. kt_step: N/m, stiffness of the
   increment; old: the fraction of the force of the last step that remains. */
DEM_INLINE void demi_law_increment(const dem_contact *c, dem_real *memory, dem_contact_force *f,
                                   dem_real kt_step, dem_real old) {
    const dem_vec3 v = c->slip;
    const dem_real kt = f->kt, ct = f->ct;
    dem_vec3 s = demi_scale(dem_memory_rotate(c, demi_at(memory)), old), t;
    dem_real cut;
    s = demi_sub(s, demi_scale(c->slip_step, kt_step*demi_law_share(c)*c->dt));
    t = demi_v(s.x - ct*v.x, s.y - ct*v.y, s.z - ct*v.z);
    cut = demi_law_cap(c, f, t, s);
    s = demi_sub(s, demi_scale(demi_law_give(c, f, t, cut), kt));
    demi_put(memory, s);
    memory[3] = kt;
    f->energy.shear_stored = demi_dot(s, s)/(2*kt + DEMI_TINY);
}
/* Mindlin's friction by increments [DIR05]: s - ct v_t, limited by Coulomb's law, where the force s
   changes by -kt ds in a step. Differs from [DIR05] in kt: it is that of the overlap in the middle
   of the step, which makes the law of second order in dt.
   Contact history: 4 reals, the vector s [N] and kt of the last step [N/m].
   Tests: tests/contact/test_impacts.c, tests/law/test_laws.c (impacts of [THO13]). */
DEM_INLINE void dem_law_mindlin(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    demi_law_increment(c, memory, f, f->kt_step, 1);
}
/* Mindlin's friction, rescaled on unloading [THO13]: as dem_law_mindlin, but while kt falls the
   force s is multiplied by kt/(kt of the last step), so that the displacement s/kt is kept. A
   change of the load of a sheared contact then creates no energy. Contact history as for
   dem_law_mindlin. Tests: tests/contact/test_impacts.c, tests/examples/test_exam.c. */
DEM_INLINE void dem_law_mindlin_rescaled(const dem_contact *c, dem_real *memory,
                                         dem_contact_force *f) {
    const dem_real kt = f->kt, before = memory[3];
    demi_law_increment(c, memory, f, kt < before ? kt : f->kt_step, kt < before ? kt/before : 1);
}

/* N m: the moment of the rolling spring in `memory` after this step. The rotation of a relative to
   b about axes in the contact plane stretches it with the stiffness kr (N m). */
DEM_INLINE dem_vec3 demi_law_roll(const dem_contact *c, const dem_real *memory, dem_real kr) {
    const dem_vec3 n = c->normal, w = c->spin_step;
    return demi_sub(dem_memory_rotate(c, demi_at(memory)),
                    demi_scale(demi_sub(w, demi_scale(n, demi_dot(w, n))),
                               kr*demi_law_share(c)*c->dt));
}
/* The fraction of a moment of magnitude `size` that the limit `most` leaves, both N m. */
DEM_INLINE dem_real demi_law_left(dem_real size, dem_real most) {
    return (most + DEMI_TINY)/((size > most ? size : most) + DEMI_TINY);
}
/* Rolling resistance of [MIL] 4.5: a moment mu_r R* min(F, |w|) against the relative spin w, with F
   in N and w in rad/s compared as printed there. It also acts on spin about the normal, and holds
   nothing at rest. No contact history. Tests: tests/law/test_laws.c, tests/hard/hard_impacts.c. */
DEM_INLINE void dem_law_roll_step(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const dem_real size = demi_length(c->spin), least = f->load < size ? f->load : size;
    (void)memory;
    f->moment = demi_scale(c->spin, -c->rolling_friction*c->r_eff*least/(size + DEMI_TINY));
    f->energy.roll = -demi_dot(f->moment, c->spin)*c->dt;
}
/* Rolling resistance of constant magnitude [ZHO99]: a moment mu_r R* F against the relative spin in
   the contact plane, and at rest any moment up to that. Differs from [ZHO99] at rest, where its
   moment is undefined: a spring acts in parallel with a dashpot behind the limit. It is as stiff as
   a step can resolve, kr = (0.3/dt)^2 I with I = 2/5 m* R*^2, and critically damped. It yields in
   proportion to dt^2 and does not creep. Contact history: 3 reals, the vector of its moment [N m].
   Tests: tests/law/test_laws.c (a sphere at rest on a slope). */
DEM_INLINE void dem_law_roll_constant(const dem_contact *c, dem_real *memory,
                                      dem_contact_force *f) {
    const dem_vec3 n = c->normal, w = demi_sub(c->spin, demi_scale(n, demi_dot(c->spin, n)));
    const dem_real per = c->dt > 0 ? 1/(c->dt + DEMI_TINY) : 0;
    const dem_real hard = 2*(c->m_eff*c->r_eff*c->r_eff)/5*per, kr = DEM_R(0.09)*hard*per;
    const dem_vec3 m = demi_law_roll(c, memory, kr);
    const dem_vec3 t = demi_sub(m, demi_scale(w, DEM_R(0.6)*hard));
    const dem_real left = demi_law_left(DEMI_SQRT(demi_dot(t, t)),
                                        c->rolling_friction*c->r_eff*f->load);
    f->moment = demi_scale(t, left);
    demi_put(memory, demi_sub(m, demi_scale(t, c->dt > 0 ? (1 - left)*DEM_R(0.09/0.69) : 0)));
    f->energy.roll = -demi_dot(f->moment, c->spin)*c->dt;
}
/* Rolling resistance of an elastic-plastic spring and a dashpot (EPSD) [AI11]. The spring has the
   stiffness kr = 2.25 k (mu_r R*)^2, where k = dF/dd is the normal stiffness (hysteretic law: kn),
   and its moment is limited to mu_r R* F. Below the limit a dashpot acts with 0.3 times the
   critical damping of I = 7/5 m* R*^2. Contact history: 3 reals, the vector of the spring's moment
   [N m]. Tests: tests/law/test_laws.c (a sphere at rest on a slope, order, time step). */
DEM_INLINE void dem_law_roll_epsd(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const dem_vec3 n = c->normal, w = demi_sub(c->spin, demi_scale(n, demi_dot(c->spin, n)));
    const dem_real arm = c->rolling_friction*c->r_eff, mr2 = c->m_eff*c->r_eff*c->r_eff;
    const dem_real kr = DEM_R(2.25)*f->slope*arm*arm, most = arm*f->load;
    const dem_real cr = DEM_R(0.6)*DEMI_SQRT(kr*7*mr2/5);
    dem_vec3 m = demi_law_roll(c, memory, DEM_R(2.25)*f->slope_step*arm*arm);
    const dem_real size = DEMI_SQRT(demi_dot(m, m));
    m = demi_scale(m, demi_law_left(size, most));
    f->moment = demi_sub(m, demi_scale(w, size > most ? 0 : cr));
    demi_put(memory, m);
    f->energy.roll = -demi_dot(f->moment, c->spin)*c->dt;
}

/* Twisting (spinning) friction: a moment about the normal of at most mu_spin R* F against the
   relative spin about the normal, and at rest any moment up to that, as with impulses. A spring
   acts in parallel with a dashpot behind the limit. As in dem_law_roll_constant it is as stiff as a
   step can resolve, k = (0.3/dt)^2 I with I = 2/5 m* R*^2, and critically damped. So it holds a
   grain at rest and does not limit the time step. It adds to the moment of a rolling law. Contact
   history: 1 real, the moment of the spring [N m]; it does not change its sign if a and b are
   exchanged. Tests: tests/law/test_twisting.c. */
DEM_INLINE void dem_law_twist(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const dem_vec3 n = c->normal;
    const dem_real per = c->dt > 0 ? 1/(c->dt + DEMI_TINY) : 0, w = demi_dot(c->spin, n);
    const dem_real hard = 2*(c->m_eff*c->r_eff*c->r_eff)/5*per, kr = DEM_R(0.09)*hard*per;
    const dem_real m = *memory - kr*demi_law_share(c)*c->dt*demi_dot(c->spin_step, n);
    const dem_real t = m - DEM_R(0.6)*hard*w;
    const dem_real left = demi_law_left(DEMI_ABS(t), c->spinning_friction*c->r_eff*f->load);
    f->moment = demi_add(f->moment, demi_scale(n, t*left));
    *memory = m - t*(c->dt > 0 ? (1 - left)*DEM_R(0.09/0.69) : 0);
    f->energy.roll -= t*left*w*c->dt;
}
/* Defines the law NAME: the user-defined law LAW with MEMORY reals of history (a constant), then
   dem_law_roll_epsd and dem_law_twist with the rolling and spinning friction of the materials.
   LAW must set f->load, f->slope and f->slope_step as the laws in examples/laws do. NAME needs
   desc.law_memory = MEMORY + 4, and one more of desc.law_vectors than LAW.
   Tests: tests/examples/test_more_laws.c. */
#define DEM_LAW_ROLLING(NAME, LAW, MEMORY) \
    DEM_INLINE void NAME(const dem_contact *c, dem_real *memory, dem_contact_force *f) { \
        LAW(c, memory + 3, f); \
        dem_law_roll_epsd(c, memory, f); \
        dem_law_twist(c, memory + 3 + (MEMORY), f); \
    }

/* ---- other functions that you may hand over ---- */

/* A force field: returns the force (N) on a body with this position (m), velocity (m/s), radius (m)
   and mass (kg) at a time (s). With impulses position, velocity and time are those of the middle of
   the coming step. It is called once per body and step, and again whenever forces are computed
   without a step (after a change of the scene, by dem_contacts_each, by the report), from several
   threads. */
typedef dem_vec3 (*dem_force_fn)(dem_vec3 position, dem_vec3 velocity, dem_real radius,
                                 dem_real mass,
                                 double time, void *user);

/* A force field that sees the whole body and may exert a torque. It adds to *force (N) and *torque
   (N m, about the centre of mass, in the world frame), which are 0 when it is called. *body is the
   state as dem_body_get returns it; spheres have an orientation only with desc.orientations. time:
   s. id: the body, to find your own data by its slot. Otherwise as dem_force_fn. */
typedef struct dem_body_state dem_body_state;
typedef void (*dem_body_force_fn)(const dem_body_state *body, dem_body id, double time,
                                  dem_vec3 *force, dem_vec3 *torque, void *user);

/* Advances the user-defined numbers of a body by one step, in place: `reals` has as many entries as
   desc.body_reals has names. rates: per second, the sum of what the law added for all contacts of
   the body. *body is its state at the end of the step, at `time` (s); dt: s. Without this function
   dem.h takes Euler's step, reals += rates dt, which is stable for dt below 2 over the fastest rate
   of decay. It is called once per body and step, from several threads. */
typedef void (*dem_reals_fn)(dem_real *reals, const dem_real *rates, const dem_body_state *body,
                             dem_body id, double time, dem_real dt, void *user);

/* Returns the rate of the radius of a body, m/s (desc.growth): > 0 grows, < 0 wears. *body is its
   state at `time` (s). Slabs call it from several threads. */
typedef dem_real (*dem_growth_fn)(const dem_body_state *body, dem_body id, double time, void *user);

/* A motion: sets the pose of a wall at a time (s). When it is called, *pose is where the wall was
   when it got the motion, at rest. It must be smooth, and velocity and spin must be the exact
   derivatives of position and rotation. It is called twice per step, for its end and its middle,
   from one thread. With impulses dem.h also calls it for the next step: it must be valid one step
   ahead.
   dem_world_check calls it too, also for later times, and reports a velocity or spin that is not
   the derivative. A pose that is not finite, is clearly no rotation, or is beyond 1e15 (m, m/s,
   rad/s) stops the run with DEM_ERROR_UNSTABLE. */
typedef void (*dem_motion_fn)(double time, dem_pose *pose, void *user);

/* Memory functions of a world. Give both or neither (malloc and free). alloc_fn returns null if
   there is no memory; free_fn receives the size that was requested. One world, or one set of slabs,
   calls them from one thread at a time. */
typedef struct dem_allocator {
    void *(*alloc_fn)(size_t size, void *user);
    void (*free_fn)(void *memory, size_t size, void *user);
    void *user;
} dem_allocator;
