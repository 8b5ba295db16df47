/* dem.h - version 0.1.0 - discrete-element (granular) simulation in one C99 header. MIT licence.

   It simulates grains: spheres of any radius (or discs, in a plane), ellipsoids and rigid clusters
   of spheres that touch, rub, roll and bounce on each other and on moving walls.

   Include it plainly wherever you use it, and define DEM_IMPLEMENTATION before the include in *one*
   C or C++ file to get the implementation. dem.c is such a file: compile it once (some 20 s with
   gcc at -O2), and your own files compile in a moment:

       cc -O2 -c dem.c                        -fopenmp if you like
       cc -O2 program.c dem.o -lm

   Contents; jump to a part by searching for its tag:
       >>manual      a complete program, conventions, one step, options, materials, lifetimes, the
                     report, errors, threads, extending, a glossary
       >>api         ids, choices, contacts and the built-in laws
       >>scene       worlds, materials, bodies, walls, feeds
       >>run         steps, measuring, files, slabs, report
       >>implementation  stop there if you only want to use it
       >>platform    compiler, OpenMP, the one parallel loop
       >>maths       vectors, poses, random numbers
       >>memory      allocation, arrays that grow, errors, the world's layout
       >>laws        the built-in contact laws, a line each
       >>materials   materials, the pair table, coefficients
       >>shapes      ellipsoids, clusters of spheres: mass properties, supports, meetings
       >>bodies      grains: slots, arrays, insertion, removal
       >>facets      what each face, edge and corner of a surface counts
       >>walls       planes, cylinders, profiles, meshes, walls of grains, sieves, their motions
       >>search      all pairs, grid, levels, linked linear list; the neighbour list
       >>lists       candidates on walls; contacts that last, carried to new lists
       >>near        neighbours that may touch soon: the pruned list that forces use
       >>rebuild     effects, skin, order of bodies, domains: all lists made anew
       >>touch       candidate pairs -> contacts: geometry only
       >>respond     contact -> force and torque: the loops that bring touch and law together
       >>on-walls    where parts of bodies touch walls: geometry only
       >>kept        contacts kept by themselves, all but sphere on sphere: touch and respond
       >>integrators kick, drift, predict; rotation
       >>ledger      where the energy went
       >>placing     room for new grains: regions, fills, packings
       >>feed        grains fed in, taken out and counted
       >>advice      which time step a scene bears
       >>check       what is likely to be wrong with a scene, before it runs
       >>step        one step after the other
       >>measure     fields on a grid, loads, balance
       >>read        meshes and profiles in
       >>write       VTP, VTK, XYZ and CSV out
       >>checkpoint  everything, to the last bit
       >>restore     a checkpoint checked and read
       >>trials      what a choice costs and changes, tried on copies of a scene
       >>world       create, destroy, report
       >>slabs       one scene dealt to threads or processes: what grains take along
       >>slabs-step  one step of all slabs
       >>slabs-time  one time step for all slabs
       >>slabs-run   what is fed into slabs; one step after the other
       >>deal        slabs made and collected
*/

/* ---------------------------------------------------------------------------------------------
   >>manual
   ---------------------------------------------------------------------------------------------
   A complete program: 5000 glass beads fall into a heap.

       #define DEM_IMPLEMENTATION
       #include "dem.h"
       #include <stdio.h>

       int main(void) {
           dem_world_desc desc = DEM_WORLD_DESC;   // zeros: nothing asked, nothing simulated
           desc.gravity.z = -9.81;                         // m/s2
           dem_world *world = dem_world_create(&desc);

           dem_material_desc glass_desc = DEM_MATERIAL_DESC;
           glass_desc.density = 2500;                      // kg/m3
           glass_desc.young = 6.4e7;                       // Pa, softened
           glass_desc.poisson = 0.23;
           glass_desc.restitution = 0.66;
           glass_desc.friction = 0.15;
           dem_material glass = dem_material_add(world, &glass_desc);

           dem_plane_add(world, glass, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
           dem_box box = dem_box_make(-0.05, -0.05, 0.01, 0.05, 0.05, 0.15);
           dem_spheres_fill(world, glass, 1.5e-3, box, 5000, 1);

           if (dem_world_run(world, 0.2, dem_progress_print, stderr) != DEM_OK)
               puts(dem_world_error(world));
           dem_world_report(world, stdout);
           dem_vtp_write(world, "pile.vtp");
           dem_world_destroy(world);
           return 0;
       }

   Conventions. SI units throughout. Overlap is positive when two bodies touch. The normal of a
   contact points from body a to body b; of a wall contact, from the grain to the wall.
   `closing_speed` is positive when the two approach. A `dem_contact_force` acts on body a, but for
   `normal`, which is the repulsion (positive pushes the two apart). Rotations are
   right-handed. Angles are in radians.

   One step, in the order in which data flows (the same numbers stand in demi_step_once):
       1 move      first half kick, drift, predicted velocity; walls follow their motion
       2 search    if something moved half the skin: sort bodies by cell, rebuild the candidate
                   list, carry contact memory over; when due, pick the near pairs from it
       3 touch     near pairs -> contacts: who, where, normal, overlap
       4 respond   contact -> force and torque, by the law chosen
       5 gather    forces are summed per body in a fixed order
       6 kick      second half kick; ledger, counters, time

   Velocities that a law sees are those of the full step, v(t) and not v(t - dt/2), for every
   integrator: half-step velocities give unphysical static friction at size ratios above 3 [VYA25].

   What dem.h does not do: fluids, breakage, bonds, heat; implicit integration; graphics.

   Options are fields of `dem_world_desc`; zero there means absent, or "chosen for you". What was
   chosen is told by dem_world_report. By what one wants to say:

       the world is ...           gravity, boundary and domain (open, periodic, outflow), planar
                                  and thickness (discs)
       contacts push by ...       normal_law; impact_speed for the linear law's stiffness; tension:
                                  may a dashpot pull as grains part?
       they rub by ...            tangent_law; friction_load and slider: what friction counts on.
                                  No friction in any pair: no spins, no memory, no price
       they roll by ...           rolling_law
       a law or force of my own   law, law_user, law_memory, law_vectors, law_stiffness; force,
                                  body_force, force_user
       bodies turn by ...         rotation, orientations; ellipsoid_overlap, cluster_contacts
       time goes by ...           integrator, dt, allow_large_dt
       it shall be fast           search, skin, threads
       where does energy go?      ledger
       whose memory?              allocator

   Materials for a first day. Density, Young's modulus and Poisson's ratio are in tables of
   materials; restitution is measured by dropping a grain (rebound height over drop height is its
   square), friction by tilting a plate. A grain needs a time step of t_c/20 to t_c/50, t_c the
   duration of a collision, which for Hertz's law is about 2.9 (m^2/(E^2 R v))^(1/5) of the reduced
   mass, modulus and radius: for glass beads of 3 mm at 1 m/s some 10 us. That is why one softens:
   E smaller by 100 makes steps longer by 100^(2/5) = 6.3 and impacts deeper by as much.
   Restitution, angles of repose and flow hardly notice while overlaps stay below 0.01 radii; what
   goes with the true stiffness (speed of sound, adhesion) does. The report tells the largest
   overlap.

   Lifetimes. What you hand over is copied at the call: descs, arrays, meshes, profiles. Functions
   and user pointers in a desc must live as long as the world. Pointers that you are handed:
       dem_bodies_get, dem_field_get     until the next call that steps or changes the world
       dem_world_error                   until the next call that fails
       dem_mesh_read and the like        until you free them, with the world that read them
   Ids stay good until what they name is removed; that of a removed body is told from that of the
   one that got its place. Indices (0 .. count - 1) change whenever bodies are sorted.

   The report (dem_world_report), line by line:
       bodies      how many, of which radii; inserted = present + removed + left
       time step   t_c, how many steps it has, what binds it: stiffen, soften or slow down that
       search      method, skin, steps from one list to the next; candidates and contacts per body
       effects     the laws in force, and what they remember per contact. "none" costs nothing
       overlap     the largest so far, over the radius: beyond 0.05 the material is too soft
       pair        what holds between each two materials, after mixing
       wall, feed, outlet   what they bear, bring and take
       ledger      the residual is what the time step gets wrong: it falls with its square

   Compile-time options:
       DEM_REAL           double (default) or float: the type of all state
       DEM_STATIC         makes every function static
       DEM_LAW            name of your contact law, to have it inlined (see >>add-law)
       DEM_NO_OPENMP      never use OpenMP, even when the compiler offers it
       DEM_NO_SPECIALIZE  always law by law, never all laws at once: slower, same bits
       DEM_NO_CLONES      kernels for the compiler's target only, not also for wider vectors
       DEM_DOMAIN_BODIES  bodies per domain, about (2048); another number gives other bits

   Memory. All of it comes from the allocator of the world desc (default malloc and free). A step
   allocates nothing once the world is warm; it may grow lists when more grains come together than
   before.

   Errors. A function that can fail returns a `dem_result`, or a null id or null pointer, and leaves
   one sentence in dem_world_error: the call, the value, the limit, the likely cause, the remedy.
   The world stays as it was before the call. If nobody reads why a part of the scene was refused,
   the next run does not begin and quotes it. Null worlds, descs and places for answers are
   answered: DEM_ERROR_ARGUMENT, a null id, 0. A run that cannot be right (a force that is not
   finite, an overlap larger than a radius) stops at the step that caused it. dem.h never prints,
   exits or aborts.

   A scene that does something else than it should: dem_check_print(world, stdout) before the first
   run says what looks wrong (units, overlaps, a floor that is missing), dem_world_report after it
   what was simulated, and dem_advise what another step, stiffness or law would change.

   Threads. Different worlds may be used from different threads. Several threads may look at one
   world at once, by functions that take it as const, while none changes it. Of those only these
   write: one that fails (its sentence), dem_world_error (that it was read), and dem_bodies_get in a
   periodic world (the places, wrapped into the box). Within a world, `threads` of the desc sets the
   OpenMP threads; the same input gives the same bits for any number of them: bodies
   are dealt to domains that depend on the number of bodies only, and every sum runs in a fixed
   order. To compare bits between builds, compile with -ffp-contract=off. Slabs (dem_slabs_create)
   deal a scene to processes, over MPI or what you have: docs/parallel.md.

   Extending. A contact law is a function and a row (>>add-law), so are a wall (>>add-wall), a shape
   (>>add-shape), an integrator (>>add-integrator), a search (>>add-search) and a mesh format
   (>>add-format); a number of each body is a field and a row (>>add-array).
   docs/extending.md walks through each, and `make recipes` performs it. Who owns what in a world
   stands at struct dem_world (>>memory).

   Glossary, of words that are ours or used in one sense:
       candidate   a pair, or a body and an element of a wall, nearer than the skin
       skin        m, how much nearer than touching two may come before a new list of candidates
       near list   candidates that may touch within some steps; forces are worked out for these
       slot        the number by which a body is known while indices change
       domain      some 2000 bodies that lie together: what one thread works on at a time
       tile        some 32 or 64 pairs whose forces are worked out together
       memory      reals that a contact keeps from step to step: springs, largest load
       slip        velocity of one surface along the other, at the contact
       species     spheres alike in material, radius, mass, and in being fixed or not
       place       where a surface of facets is nearest to a body; counted by its share
       part        a sphere of a cluster, or the one sphere or ellipsoid that a body is
       kept        of a contact: by itself, in a list, not in a column of the near list
       spin        angular velocity of a body, as in the literature of granular gases
       reduced     of two bodies: R* = Ra Rb/(Ra + Rb), m* likewise, E* in series (Hertz)
       ghost       copy of a grain that belongs to the slab below
       ledger      account of energy: put in, stored, lost, and what is left over

   References, by the keys used below:
     [AI11]    Ai, Chen, Rotter & Ooi, Powder Technol. 206 (2011) 269: rolling resistance
     [ALK07]   Alkhaldi, Contact Investigations of Granular Mechanical Media in a Tumbling Sorting
               Machine, thesis, Stuttgart 2007: screening, hysteresis, MOLDYN
     [BER23]   Berry, Zhang & Haeri (2023): what clusters of spheres count twice
     [CS79]    Cundall & Strack, Geotechnique 29 (1979) 47
     [DIM04]   Di Maio & Di Renzo, Chem. Eng. Sci. 59 (2004) 3461: linear stiffness for a speed
     [DIR05]   Di Renzo & Di Maio, Chem. Eng. Sci. 60 (2005) 1303: Mindlin by increments
     [DLM97]   Dullweber, Leimkuhler & McLachlan, J. Chem. Phys. 107 (1997) 5840: splitting
     [ERI05]   Ericson, Real-Time Collision Detection (2005): closest point on a triangle
     [FIN92]   Fincham, Mol. Simul. 8 (1992) 165: leapfrog for rotation
     [HER82]   Hertz, J. reine angew. Math. 92 (1882) 156
     [HOA61]   Hoare, Comm. ACM 4 (1961) 321: the k-th of many by exchanges
     [MIL]     a thesis on tumbling mills on a GPU: laws by the step, meshes, segments
     [OGA12]   Ogarko & Luding, Comput. Phys. Commun. 183 (2012) 931: hierarchical grids
     [PW85]    Perram & Wertheim, J. Comput. Phys. 58 (1985) 409: contact function of ellipsoids
     [RUB15]   Rubio-Largo, Lind, Maza & Hidalgo (2015): granular gas of ellipsoids on GPUs
     [SP07]    Schwager & Poeschel, Granul. Matter 9 (2007) 465: restitution of the linear dashpot
     [SPI24]   del Valle et al., Comput. Phys. Commun. 297 (2024) 109077: SPIRAL
     [THO13]   Thornton, Cummins & Cleary, Powder Technol. 233 (2013) 30: rescaling on unloading
     [TSU92]   Tsuji, Tanaka & Ishida, Powder Technol. 71 (1992) 239: delta^(1/4) damping
     [VYA25]   Vyas et al., Comput. Phys. Commun. 310 (2025): law velocities at the full step
     [ZHO99]   Zhou et al., Physica A 269 (1999) 536: constant rolling torque
*/

/* ---------------------------------------------------------------------------------------------
   >>api
   --------------------------------------------------------------------------------------------- */
#ifndef DEM_H
#define DEM_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#define DEM_VERSION_MAJOR 0
#define DEM_VERSION_MINOR 1
#define DEM_VERSION_PATCH 0
#define DEM_VERSION (DEM_VERSION_MAJOR*10000 + DEM_VERSION_MINOR*100 + DEM_VERSION_PATCH)

#ifndef DEM_REAL
#define DEM_REAL double
#endif
typedef DEM_REAL dem_real;
#define DEM_R(x) ((dem_real)(x))

#if defined(DEM_STATIC) && defined(__GNUC__)
#define DEM_API static __attribute__((unused))
#elif defined(DEM_STATIC)
#define DEM_API static
#else
#define DEM_API extern
#endif

/* Inlined whatever it takes: contact laws named by DEM_LAW, and functions whose triples of numbers
   would otherwise go through memory, which costs more than their arithmetic. Not where the compiler
   is asked not to optimise: code then only grows by it. */
#if defined(__GNUC__) && defined(__OPTIMIZE__) && !defined(__TINYC__)
#define DEM_INLINE static inline __attribute__((always_inline))
#else
#define DEM_INLINE static inline
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- results ---- */
typedef enum dem_result {
    DEM_OK = 0,
    DEM_ERROR_ARGUMENT,  /* a value outside its limits, an id that names nothing */
    DEM_ERROR_MEMORY,    /* the allocator gave nothing */
    DEM_ERROR_FILE,      /* a file could not be opened, read, written or renamed */
    DEM_ERROR_FORMAT,    /* a file's contents are not what the format says; or of another version */
    DEM_ERROR_TIME_STEP, /* the time step is larger than the stiffest contact allows */
    DEM_ERROR_UNSTABLE,  /* the run blew up: a force not finite, an overlap beyond a radius */
    DEM_ERROR_STOPPED    /* the progress callback asked to stop */
} dem_result;

/* ---- vectors, boxes, poses ---- */
typedef struct dem_vec3 { dem_real x, y, z; } dem_vec3;
typedef struct dem_box { dem_vec3 lo, hi; } dem_box;
/* A unit quaternion: turns from a body's own frame into the world. w is the scalar part. */
typedef struct dem_quat { dem_real w, x, y, z; } dem_quat;

/* Where a rigid wall is and how it moves. rotation is row-major: world = position + rotation *
   local. */
typedef struct dem_pose {
    dem_vec3 position;    /* m */
    dem_real rotation[9]; /* orthonormal, 3 x 3 */
    dem_vec3 velocity;    /* m/s, of `position` */
    dem_vec3 spin;        /* rad/s, about `position` */
} dem_pose;

DEM_INLINE dem_vec3 dem_vec3_make(dem_real x, dem_real y, dem_real z) {
    dem_vec3 v; v.x = x; v.y = y; v.z = z; return v;
}
DEM_INLINE dem_box dem_box_make(dem_real x0, dem_real y0, dem_real z0, dem_real x1, dem_real y1,
                                dem_real z1) {
    dem_box b; b.lo = dem_vec3_make(x0, y0, z0); b.hi = dem_vec3_make(x1, y1, z1); return b;
}

DEM_INLINE dem_quat dem_quat_make(dem_real w, dem_real x, dem_real y, dem_real z) {
    dem_quat q; q.w = w; q.x = x; q.y = y; q.z = z; return q;
}
/* The rotation by angle (rad) about an axis of any length but 0. */
DEM_API dem_quat dem_quat_about(dem_vec3 axis, dem_real angle);
/* First b, then a. */
DEM_INLINE dem_quat dem_quat_times(dem_quat a, dem_quat b) {
    return dem_quat_make(a.w*b.w - a.x*b.x - a.y*b.y - a.z*b.z,
                         a.w*b.x + a.x*b.w + a.y*b.z - a.z*b.y,
                         a.w*b.y - a.x*b.z + a.y*b.w + a.z*b.x,
                         a.w*b.z + a.x*b.y - a.y*b.x + a.z*b.w);
}
/* v of the body's frame, in the world. */
DEM_INLINE dem_vec3 dem_quat_rotate(dem_quat q, dem_vec3 v) {
    const dem_real x = 2*(q.y*v.z - q.z*v.y), y = 2*(q.z*v.x - q.x*v.z), z = 2*(q.x*v.y - q.y*v.x);
    return dem_vec3_make(v.x + q.w*x + q.y*z - q.z*y, v.y + q.w*y + q.z*x - q.x*z,
                         v.z + q.w*z + q.x*y - q.y*x);
}
/* v of the world, in the body's frame. */
DEM_INLINE dem_vec3 dem_quat_unrotate(dem_quat q, dem_vec3 v) {
    return dem_quat_rotate(dem_quat_make(q.w, -q.x, -q.y, -q.z), v);
}

/* ---- ids: all-zero names nothing ---- */
typedef struct dem_material { int32_t id; } dem_material;                    /* id counts from 1 */
typedef struct dem_wall { int32_t id; } dem_wall;                            /* id counts from 1 */
typedef struct dem_field { int32_t id; } dem_field;                          /* id counts from 1 */
typedef struct dem_shape { int32_t id; } dem_shape;        /* id counts from 1; 0: a sphere */
typedef struct dem_body { uint32_t slot, generation; } dem_body;  /* slot counts from 1 */

typedef struct dem_world dem_world;

/* ---- choices ---- */
typedef enum dem_normal_law {
    DEM_NORMAL_HERTZ = 0,  /* F = kn delta^(3/2) + cn delta^(1/4) v  [HER82, TSU92] */
    DEM_NORMAL_LINEAR,     /* F = kn delta + cn v; kn given, or from Young's modulus and a speed */
    DEM_NORMAL_HYSTERETIC, /* [ALK07] eq 2.47: loads along kn delta, unloads and reloads with slope
                              kun, pulls by at most kad delta; needs no dashpot */
} dem_normal_law;

typedef enum dem_tangent_law {
    DEM_TANGENT_AUTO = 0,       /* DEM_TANGENT_SPRING when any pair has friction, else none */
    DEM_TANGENT_NONE,           /* no tangential force at all */
    DEM_TANGENT_VISCOUS,        /* -ct v_t, capped by Coulomb */
    DEM_TANGENT_STEP,           /* [MIL]: -kt (v_t dt) - ct v_t, capped; without memory */
    DEM_TANGENT_SPRING,         /* [CS79]: -kt xi - ct v_t, xi = integral of v_t dt, capped */
    DEM_TANGENT_MINDLIN,  /* [DIR05]: increments of force, kt of the present overlap; capped */
    DEM_TANGENT_MINDLIN_RESCALED, /* [THO13]: the same, scaled down with kt while unloading */
} dem_tangent_law;

typedef enum dem_rolling_law {
    DEM_ROLLING_AUTO = 0,   /* DEM_ROLLING_EPSD when any pair has rolling friction, else none */
    DEM_ROLLING_NONE,
    DEM_ROLLING_STEP,       /* [MIL] section 4.5: mu_r R min(Fn, |w|), dimensions as printed */
    DEM_ROLLING_CONSTANT,   /* [ZHO99]: mu_r R* Fn against the relative spin; at rest up to that */
    DEM_ROLLING_EPSD,       /* [AI11]: elastic-plastic spring-dashpot, with memory */
} dem_rolling_law;

typedef enum dem_tension {
    DEM_TENSION_KEPT = 0,  /* the dashpot may pull at the end of a contact: restitution is as set */
    DEM_TENSION_CLIPPED,   /* never pull: the contact ends at zero force; restitution comes out
                              higher (.66 gives about .69) [SP07] */
    DEM_TENSION_NONE       /* never pull, and damped so that restitution is as set all the same:
                              the closed form of [SP07] solved for the dashpot, as in [THO13] */
} dem_tension;

/* What friction's limit is mu times of, where the normal force has a dashpot. */
typedef enum dem_load {
    DEM_LOAD_PUSH = 0,     /* the whole normal force, 0 while it pulls: Coulomb's law at every
                              instant. Over an impact that slides throughout, friction's impulse is
                              more than mu times the normal one: by 9 % at e = .25, 14 % at .1 */
    DEM_LOAD_ELASTIC,      /* the spring's part of it: the impulse is mu times the normal impulse
                              whatever the restitution, as a rigid body's is */
    DEM_LOAD_SIZE          /* its size, pulling or pushing, as LAMMPS, LIGGGHTS and MercuryDPM have
                              it: 18 % at e = .25, 28 % at .1 */
} dem_load;

/* How the tangential spring and dashpot meet friction's limit. Force and slip are the same while
   nothing slides, and once all slides; they differ in what the spring holds on the way. */
typedef enum dem_slider {
    DEM_SLIDER_SHARED = 0, /* side by side behind the slider: together they hold what friction can.
                              Never makes energy */
    DEM_SLIDER_SPRING,     /* the spring alone holds it: what [THO13] and its published impacts
                              have; makes up to 3 % of an impact's energy at e = .5, 15 % at .1 */
    DEM_SLIDER_REST        /* the spring holds what the dashpot leaves of it, as LAMMPS, MercuryDPM
                              and MFiX have it; stores energy that the slip did not bring */
} dem_slider;

typedef enum dem_convention {
    DEM_CONVENTION_STANDARD = 0, /* E*, G*, R*, m* and overlap as in the contact literature */
    DEM_CONVENTION_MILL          /* [MIL] Fig 5.23: E* = E, 8 G, half overlaps between grains, R/2
                                    and m/2 against walls. For reproducing that thesis only */
} dem_convention;

typedef enum dem_integrator {
    DEM_VELOCITY_VERLET = 0, /* second order; the default */
    DEM_FORWARD_EULER,       /* first order, gains energy; what [MIL] used */
    DEM_SYMPLECTIC_EULER,    /* first order, energy bounded */
    DEM_POSITION_VERLET,     /* original Verlet: x(t+dt) = 2 x(t) - x(t-dt) + a dt^2 */
    DEM_LEAPFROG,            /* velocities kept at half steps; same path as velocity Verlet */
} dem_integrator;

/* How bodies that are not spheres turn. All keep angular momentum to round-off while nothing
   pushes, and are of second order in dt under torques; docs/shapes.md has their errors and
   prices. */
typedef enum dem_rotation {
    DEM_ROTATION_SPIRAL = 0,   /* [SPI24], with angular momentum kept: the most accurate */
    DEM_ROTATION_FINCHAM,      /* [FIN92], what [RUB15] used: cheap, gains energy */
    DEM_ROTATION_NO_SQUISH     /* splitting [DLM97]: energy without drift, dearest */
} dem_rotation;

/* What counts as the overlap of two ellipsoids. W0: both scaled by it about their centres touch in
   one point; hA, hB: their heights along the normal there. */
typedef enum dem_overlap {
    DEM_OVERLAP_CONSERVATIVE = 0, /* l (1 - W0), l the sum of the radii of spheres of their volumes;
                                     the force is its gradient, with a radius of equal volume for
                                     the stiffness: conserves energy (built-in laws) */
    DEM_OVERLAP_CHORD,            /* [RUB15] 3.2: the piece of the line V2 V3 that lies in both */
    DEM_OVERLAP_NORMAL            /* (hA + hB)(1 - W0): along the normal */
} dem_overlap;

/* Contacts of two bodies, one a cluster, through several spheres at once. */
typedef enum dem_sharing {
    DEM_SHARING_ONE = 0,       /* those that push the same way are one contact in all: stiffness and
                                  restitution do not depend on how many spheres touch [BER23] */
    DEM_SHARING_NONE           /* each is a contact by itself: stiffness grows with their number;
                                  conserves elastic energy exactly */
} dem_sharing;

typedef enum dem_search {
    DEM_SEARCH_AUTO = 0,     /* grid, or levels where radii differ so much that they pay; which and
                                why is in dem_world_report */
    DEM_SEARCH_ALL_PAIRS,    /* every pair; the oracle for the others */
    DEM_SEARCH_GRID,         /* uniform grid of cells */
    DEM_SEARCH_LINKED_LIST,  /* linked linear list [ALK07] 2.3.2: sorted box ends on three axes */
    DEM_SEARCH_LEVELS        /* hierarchical grid [OGA12]: each class of radii has its own cells */
} dem_search;

typedef enum dem_boundary {
    DEM_BOUNDARY_OPEN = 0,   /* bodies may leave the domain box; nothing happens */
    DEM_BOUNDARY_PERIODIC,   /* leaves on one side, enters on the other */
    /* bodies whose centre leaves the box are taken out in that step and counted as left; each time
       a new list of neighbours is made: many that leave one by one are cheaper with an outlet */
    DEM_BOUNDARY_OUTFLOW
} dem_boundary;

/* ---- maths that laws are written with; not meant for more ---- */
/* Maths in the precision of dem_real; the choice folds away at compile time. */
#define DEMI_SINGLE (sizeof(dem_real) == sizeof(float))
#define DEMI_SQRT(x) (DEMI_SINGLE ? (dem_real)sqrtf((float)(x)) : (dem_real)sqrt((double)(x)))
#define DEMI_ABS(x) (DEMI_SINGLE ? (dem_real)fabsf((float)(x)) : (dem_real)fabs((double)(x)))
/* Added to a length before dividing by it. */
#define DEMI_TINY (DEMI_SINGLE ? DEM_R(1e-30) : DEM_R(1e-200))
#if defined(__GNUC__) && !defined(__TINYC__) && !defined(__cplusplus)
extern double sqrt(double) __attribute__((const));  /* "const": does not set errno, so that roots */
extern float sqrtf(float) __attribute__((const));  /* can be vectorised without -fno-math-errno */
#endif
DEM_INLINE dem_vec3 demi_v(dem_real x, dem_real y, dem_real z) { return dem_vec3_make(x, y, z); }
DEM_INLINE dem_vec3 demi_at(const dem_real *p) { return dem_vec3_make(p[0], p[1], p[2]); }
DEM_INLINE dem_vec3 demi_add(dem_vec3 a, dem_vec3 b) { return demi_v(a.x + b.x, a.y + b.y, a.z +
    b.z); }
DEM_INLINE dem_vec3 demi_sub(dem_vec3 a, dem_vec3 b) { return demi_v(a.x - b.x, a.y - b.y, a.z -
    b.z); }
DEM_INLINE dem_vec3 demi_scale(dem_vec3 a, dem_real s) { return demi_v(a.x*s, a.y*s, a.z*s); }
DEM_INLINE dem_real demi_dot(dem_vec3 a, dem_vec3 b) { return a.x*b.x + a.y*b.y + a.z*b.z; }
DEM_INLINE dem_vec3 demi_cross(dem_vec3 a, dem_vec3 b) {
    return demi_v(a.y*b.z - a.z*b.y, a.z*b.x - a.x*b.z, a.x*b.y - a.y*b.x);
}
DEM_INLINE dem_real demi_length(dem_vec3 a) { return DEMI_SQRT(demi_dot(a, a)); }
DEM_INLINE void demi_put(dem_real *p, dem_vec3 v) { p[0] = v.x; p[1] = v.y; p[2] = v.z; }

/* ---- a contact, and a law of one's own ---- */

/* What a law sees: this contact and nothing else. Velocities are of body a relative to body b, or
   to the wall's surface, at the full step: what dashpots and friction take. Displacements kept in
   memory grow by slip_step dt, the very displacement of the step: so springs conserve energy as the
   integrator does. */
typedef struct dem_contact {
    dem_real overlap;        /* m, > 0 */
    dem_real closing_speed;  /* m/s, positive while approaching */
    dem_vec3 normal;         /* unit, from a to b */
    dem_vec3 slip;           /* m/s, tangential velocity at the contact point, rotation included */
    dem_vec3 spin;           /* rad/s, spin of a minus spin of b */
    dem_vec3 slip_step;  /* m/s, slip averaged over the step just taken: what memory integrates */
    dem_vec3 spin_step;      /* rad/s, spin averaged over the step just taken */
    dem_vec3 normal_rate;    /* 1/s, how the normal turned in that step; for dem_memory_rotate */
    dem_real twist;          /* rad/s, how the contact plane turned about the normal */
    dem_real r_eff;          /* m,  1/(1/Ra + 1/Rb);  Ra against a wall */
    dem_real m_eff;          /* kg, 1/(1/ma + 1/mb);  ma against a wall */
    dem_real dt;             /* s, to integrate memory with; 0: memory must be left as it is */
    dem_real kn, cn;  /* built-in law: N/m^(3/2), N s/m^(5/4) (Hertz) or N/m, N s/m (linear) */
    dem_real kt, ct;  /* built-in law: N/m^(3/2), N s/m^(5/4) (Hertz) or N/m, N s/m (linear) */
    dem_real kun, kad;       /* N/m, hysteretic law: unloading, adhesion; otherwise 0 */
    dem_real friction, friction_static, rolling_friction;
    int32_t material_a, material_b; /* dem_material ids */
    int32_t wall;            /* 0: b is a grain; otherwise the dem_wall id */
    int tension, friction_load, slider;  /* dem_tension, dem_load, dem_slider: as in the desc */
    void *user;              /* law_user of the world desc */
} dem_contact;

/* Where the energy of one contact goes in one step, J. */
typedef struct dem_contact_energy {
    dem_real dashpot, sag;   /* lost to the normal dashpot, and to hysteresis */
    dem_real elastic;        /* stored by the normal spring */
    dem_real shear_work;     /* done against the tangential force */
    dem_real slide;          /* lost to sliding */
    dem_real shear_stored;   /* stored by the tangential spring */
    dem_real roll;           /* lost to rolling resistance */
} dem_contact_energy;

/* What a law answers. Zeroed before the law is called. */
typedef struct dem_contact_force {
    dem_real normal;         /* N, repulsion: positive pushes apart */
    dem_vec3 tangent;        /* N, on a (b gets the opposite), at the contact point */
    dem_vec3 moment;         /* N m, on a (b gets the opposite): rolling resistance */
    /* what a normal law hands to one of friction and one of rolling, see dem_law_hertz; a law that
       calls neither may leave it alone */
    dem_real elastic;        /* N, the spring's part of `normal` */
    dem_real load;           /* N, >= 0: friction's limit is friction times that */
    dem_real slope, slope_step;  /* N/m, d(elastic)/d(overlap): now, in the middle of the step */
    dem_real kt, kt_step;    /* N/m, tangential stiffness: the same */
    dem_real ct;             /* N s/m, tangential dashpot */
    dem_contact_energy energy;   /* for the ledger: what your law leaves at 0 it cannot know */
} dem_contact_force;

/* A contact law. memory holds law_memory reals that start at zero when the contact begins and are
   kept while it lasts. Must not look at anything but its arguments and c->user; is called from
   several threads. When a contact turns round (a and b change places) the first 3*law_vectors reals
   of the memory change sign: put there what is a vector, such as a tangential spring, and scalars
   after them. */
typedef void (*dem_law_fn)(const dem_contact *c, dem_real *memory, dem_contact_force *force);

/* A vector kept in contact memory, carried along with the contact plane over the last step: turned
   with the normal, spun with the mean twist of the two bodies; lies in the tangent plane, keeps its
   length. Laws with memory begin with this. (Rotation by n_old -> n is exact to sixth order of the
   angle of one step.) */
DEM_INLINE dem_vec3 dem_memory_rotate(const dem_contact *c, dem_vec3 v) {
    const dem_vec3 n = c->normal, r = c->normal_rate;
    const dem_real g = v.x*n.x + v.y*n.y + v.z*n.z;      /* what sticks out of the plane */
    const dem_real e = c->dt*c->dt*(r.x*r.x + r.y*r.y + r.z*r.z);  /* sin^2 of the angle */
    const dem_real h = g*c->dt*(DEM_R(0.5) + e/8);       /* 1/(1 + cos) */
    const dem_real t = c->dt*c->twist, q = 1 - t*t/2;
    const dem_real x = v.x - g*n.x + h*r.x, y = v.y - g*n.y + h*r.y, z = v.z - g*n.z + h*r.z;
    dem_vec3 out;
    out.x = q*x + t*(n.y*z - n.z*y);
    out.y = q*y + t*(n.z*x - n.x*z);
    out.z = q*z + t*(n.x*y - n.y*x);
    return out;
}

/* ---- the built-in laws ----
   Each is a function like one of your own, and a law of your own may call them: first one for the
   normal force, then one for friction, then one for rolling. Each of the later ones takes from the
   answer what the normal law has put there: the load, and how stiff the contact is at its present
   overlap. `memory` is where the law's own reals begin: as many as its comment says, vectors first.
   Coefficients (kn, cn, kt, ct and so on) come with the contact. None has a branch that depends on
   the contact, so that compilers turn loops over them into vector code. `energy` in the answer is
   for the ledger. */

/* For a normal law: sets what friction may count on from the elastic and the whole normal force, as
   friction_load says, and takes away what pulls, if tension says so. hold: N, what adhesion holds
   besides, 0 if there is none. */
DEM_INLINE void dem_law_load(const dem_contact *c, dem_contact_force *f, dem_real hold) {
    const int clipped = c->tension != DEM_TENSION_KEPT;
    const dem_real least = f->elastic < 0 ? f->elastic : 0;  /* adhesion may pull, no dashpot */
    const dem_real whole = (clipped || c->friction_load != DEM_LOAD_ELASTIC ? f->normal
                                                                          : f->elastic) + hold;
    const dem_real size = f->normal < 0 ? -f->normal : f->normal;
    f->load = whole > 0 ? whole : 0;
    if (!clipped && c->friction_load == DEM_LOAD_SIZE) f->load = size;
    if (clipped) f->normal = f->normal < least ? least : f->normal;
    f->energy.dashpot = (f->normal - f->elastic)*c->closing_speed*c->dt;
}
/* Memory grows by what happened in the step. That is of second order in dt with the stiffness of
   the middle of the time in which the two touched: of the overlap half way between what it was a
   step ago, 0 at least, and now. Answers which part of the step that was, 1 unless they have just
   met. Checked by "tangential and rolling memory is of second order". */
DEM_INLINE dem_real demi_law_share(const dem_contact *c) {
    const dem_real gone = c->closing_speed*c->dt;
    return c->overlap > gone ? 1 : c->overlap/(gone + DEMI_TINY);
}
DEM_INLINE dem_real demi_law_middle(const dem_contact *c) {
    const dem_real gone = c->closing_speed*c->dt;
    return (c->overlap + (c->overlap > gone ? c->overlap - gone : 0))/2;
}

/* F = kn d^(3/2) + cn d^(1/4) v [HER82, TSU92]; kt as d^(1/2), ct as d^(1/4). No memory. */
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
/* F = kn d + cn v. No memory. */
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
/* Hysteretic [ALK07] eq 2.41 to 2.49:
       F = kun d - (kun - kn) D,  D: depth, N/m and m
   loading (d = D): F = kn d; un- and reloading: slope kun, zero at d0 = (1 - kn/kun) D [2.44];
   pulling: F = -kad d, on which D shrinks with d, so that reloading from any point of it, at slope
   kun, meets kn d again at the D that belongs to that point. D is all there is to remember: the
   larger of D and d, but at most d (kun + kad)/(kun - kn). The branches meet at
   d_ad = (kun - kn) D/(kun + kad) = (1 - e^2) kn D/(kn + kad e^2), e^2 = kn/kun. That is eq 2.49
   with kad as a size; with the negative slope [ALK07] defines it as, its 2.48 and 2.49 have the
   wrong sign, and its text calls d_ad a deformation and a force. Friction is what F + kad d can
   hold, which is 0 at the pulling line; [ALK07] takes |F|, which is 0 where nothing pulls or pushes
   and large where the two are torn apart.
   Along the slope kun nothing is lost: a grain at rest on one swings there for ever unless
   normal_damping calms it. Stored is F^2/(2 kun); a D that changes dissipates F (1 - kn/kun) dD,
   summed exactly along either line. Memory: D, m, no vector.
   Tests: "a hysteretic contact dissipates the area of its loop". */
DEM_INLINE void dem_law_hysteretic(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const dem_real kn = c->kn, kun = c->kun, kad = c->kad, soft = kun - kn, before = memory[0];
    const dem_real loaded = c->overlap > before ? c->overlap : before;
    const dem_real most = c->overlap*(kun + kad)/(soft + DEMI_TINY);
    const dem_real depth = most < loaded ? most : loaded;
    memory[0] = depth;
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

/* Friction caps a trial force t by Coulomb: by friction_static while it holds, by friction when it
   slides. Answers which part of t is left; what is cut off is sliding. */
DEM_INLINE dem_real demi_law_cap(const dem_contact *c, dem_contact_force *f, dem_vec3 t) {
    const dem_real size = DEMI_SQRT(demi_dot(t, t)), cap = f->load*c->friction;
    dem_real cut = size > f->load*c->friction_static ? size : cap;
    cut = (cap + DEMI_TINY)/(cut + DEMI_TINY);
    f->tangent = demi_scale(t, cut);
    f->energy.shear_work = -demi_dot(f->tangent, c->slip)*c->dt;
    return cut;
}
/* No memory, a dashpot of so many N s/m. */
DEM_INLINE void demi_law_dashpot(const dem_contact *c, dem_contact_force *f, dem_real ct) {
    const dem_vec3 v = c->slip;
    const dem_real cut = demi_law_cap(c, f, demi_v(-ct*v.x, -ct*v.y, -ct*v.z));
    f->energy.slide = cut < 1 ? f->energy.shear_work : 0;
}
/* -ct v, capped; [MIL] 4.3. No memory. */
DEM_INLINE void dem_law_viscous(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    (void)memory;
    demi_law_dashpot(c, f, f->ct);
}
/* -kt (v dt) - ct v, capped; [MIL] 4.2. No memory. */
DEM_INLINE void dem_law_step(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    (void)memory;
    demi_law_dashpot(c, f, f->kt*c->dt + f->ct);
}
/* The length by which a spring gives way when (1 - cut) t of a trial force t is cut off, m:
       shared   the part of spring and dashpot side by side, kt dt/(kt dt + ct), so that the two
                together hold what friction can
       rest     all, so that spring and dashpot of the present slip do
       spring   all and the dashpot's share besides, so that the spring alone does.
   The dashpot's share comes from nowhere there. */
DEM_INLINE dem_vec3 demi_law_give(const dem_contact *c, dem_contact_force *f, dem_vec3 t,
                                  dem_real cut) {
    const dem_real shared = (1 - cut)*c->dt/(f->kt*c->dt + f->ct + DEMI_TINY);
    const dem_real all = (c->dt > 0 ? 1 - cut : 0)/(f->kt + DEMI_TINY);      /* m/N */
    dem_vec3 lost = demi_scale(t, c->slider == DEM_SLIDER_SHARED ? shared : all);
    if (c->slider == DEM_SLIDER_SPRING)
        lost = demi_add(lost, demi_scale(c->slip, c->dt > 0 && cut < 1 ? f->ct/(f->kt + DEMI_TINY)
                                                  : 0));
    f->energy.slide = cut*demi_dot(t, lost);
    return lost;
}
/* -kt s - ct v, capped; s: displacement, carried along with the contact plane [CS79]. Memory: s, m,
   a vector. */
DEM_INLINE void dem_law_spring(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const dem_vec3 v = c->slip;
    const dem_real kt = f->kt, ct = f->ct;
    dem_vec3 s = dem_memory_rotate(c, demi_at(memory)), t;
    dem_real cut;
    s = demi_add(s, demi_scale(c->slip_step, demi_law_share(c)*c->dt));
    t = demi_v(-kt*s.x - ct*v.x, -kt*s.y - ct*v.y, -kt*s.z - ct*v.z);
    cut = demi_law_cap(c, f, t);
    s = demi_add(s, demi_law_give(c, f, t, cut));
    demi_put(memory, s);
    f->energy.shear_stored = kt*demi_dot(s, s)/2;
}
/* Increments of force at the stiffness of the step's middle [DIR05]; old: what is left of the force
   of the step before. */
DEM_INLINE void demi_law_increment(const dem_contact *c, dem_real *memory, dem_contact_force *f,
                                   dem_real kt_step, dem_real old) {
    const dem_vec3 v = c->slip;
    const dem_real kt = f->kt, ct = f->ct;
    dem_vec3 s = demi_scale(dem_memory_rotate(c, demi_at(memory)), old), t;
    dem_real cut;
    s = demi_sub(s, demi_scale(c->slip_step, kt_step*demi_law_share(c)*c->dt));
    t = demi_v(s.x - ct*v.x, s.y - ct*v.y, s.z - ct*v.z);
    cut = demi_law_cap(c, f, t);
    s = demi_sub(s, demi_scale(demi_law_give(c, f, t, cut), kt));
    demi_put(memory, s);
    memory[3] = kt;
    f->energy.shear_stored = demi_dot(s, s)/(2*kt + DEMI_TINY);
}
/* [DIR05]: s grows by -kt ds at kt of the present overlap; s - ct v, capped. Memory: s, N, a
   vector, and kt of the last step, N/m. */
DEM_INLINE void dem_law_mindlin(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    demi_law_increment(c, memory, f, f->kt_step, 1);
}
/* [THO13]: the same, but unloading keeps the length s/kt: where kt falls, s falls with it. Memory
   as above. */
DEM_INLINE void dem_law_mindlin_rescaled(const dem_contact *c, dem_real *memory,
                                         dem_contact_force *f) {
    const dem_real kt = f->kt, before = memory[3];
    demi_law_increment(c, memory, f, kt < before ? kt : f->kt_step, kt < before ? kt/before : 1);
}

/* The moment of a spring m that takes up the relative rotation across the normal, at kr of the
   step's middle, N m. */
DEM_INLINE dem_vec3 demi_law_roll(const dem_contact *c, const dem_real *memory, dem_real kr) {
    const dem_vec3 n = c->normal, w = c->spin_step;
    return demi_sub(dem_memory_rotate(c, demi_at(memory)),
                    demi_scale(demi_sub(w, demi_scale(n, demi_dot(w, n))),
                               kr*demi_law_share(c)*c->dt));
}
/* What rolling friction leaves of a moment of size `size`, at most `most`, both N m. */
DEM_INLINE dem_real demi_law_left(dem_real size, dem_real most) {
    return (most + DEMI_TINY)/((size > most ? size : most) + DEMI_TINY);
}
/* mu_r R min(F, |w|) against the relative spin w: [MIL] 4.5, dimensions as printed. No memory. */
DEM_INLINE void dem_law_roll_step(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const dem_real size = demi_length(c->spin), least = f->load < size ? f->load : size;
    (void)memory;
    f->moment = demi_scale(c->spin, -c->rolling_friction*c->r_eff*least/(size + DEMI_TINY));
    f->energy.roll = -demi_dot(f->moment, c->spin)*c->dt;
}
/* mu_r R* F against the rotation [ZHO99], which at rest must be whatever holds it. That takes a
   spring, as stiff as a step can resolve, kr = (.3/dt)^2 I of the lighter's inertia I = 2/5 m*
   R*^2, critically damped and shared with the limit. What it yields goes with dt^2; nothing creeps.
   Memory: its moment, N m, a vector. */
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
/* EPSD [AI11]: a spring kr = 2.25 k (mu_r R*)^2, k = dF/dd the normal stiffness, held at mu_r R* F;
   below that a dashpot of .3 times the critical one of I = 7/5 m* R*^2. Memory: the spring's
   moment, N m, a vector. */
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

/* Force in N on a body at position (m) with velocity (m/s), of radius (m) and mass (kg), at time
   (s). Called once per body and step, from several threads. */
typedef dem_vec3 (*dem_force_fn)(dem_vec3 position, dem_vec3 velocity, dem_real radius,
                                 dem_real mass,
                                 double time, void *user);

/* The same, with the whole body to look at, and a torque to answer: force (N) and torque (N m,
   about the centre of mass, in the world's frame) are zero when it is called. body: as dem_body_get
   tells, orientation included (that of a sphere is followed when the desc asks for orientations),
   at the present time (s). id: for numbers of your own, kept by slot. */
typedef struct dem_body_state dem_body_state;
typedef void (*dem_body_force_fn)(const dem_body_state *body, dem_body id, double time,
                                  dem_vec3 *force, dem_vec3 *torque, void *user);

/* Fills in a wall's pose at a time (s). Called twice a step (for its end and its middle) from one
   thread. Must be smooth, with velocity and spin the exact derivatives of position and rotation. */
typedef void (*dem_motion_fn)(double time, dem_pose *pose, void *user);

/* Both functions or neither. size is given back on release. May be called from one thread at a
   time. */
typedef struct dem_allocator {
    void *(*alloc_fn)(size_t size, void *user);
    void (*free_fn)(void *memory, size_t size, void *user);
    void *user;
} dem_allocator;

/* ---------------------------------------------------------------------------------------------
   >>scene
   What a scene is made of, in the order in which a program builds it: the world, materials, grains
   and other bodies, walls, feeds and outlets.
   --------------------------------------------------------------------------------------------- */

/* ---- world ---- */
typedef struct dem_world_desc {
    dem_vec3 gravity;              /* m/s2; 0: none */
    dem_box domain;                /* m; needed for periodic and outflow boundaries; 0: unbounded */
    dem_boundary boundary[3];      /* per axis */
    int planar;  /* 1: discs in the x-y plane: z and the spins about x, y stay put */
    dem_real thickness;            /* m, of discs; 0: 1 m */

    dem_normal_law normal_law;
    dem_tangent_law tangent_law;
    dem_rolling_law rolling_law;
    dem_tension tension;
    dem_load friction_load;
    dem_slider slider;
    dem_convention convention;
    dem_law_fn law;                /* your law; replaces normal, tangential and rolling laws */
    void *law_user;                /* handed to your law as c->user */
    int law_memory;                /* reals of memory per contact for your law, 0..8 */
    int law_vectors;  /* how many leading triples of them are vectors, 0..law_memory/3 */
    dem_real law_stiffness;  /* N/m, the stiffest your law gets: for the time step; 0: built-in */

    dem_force_fn force;            /* force field of your own; 0: none */
    dem_body_force_fn body_force;  /* with torque; 0: none. Both may be given: they add up */
    void *force_user;              /* handed to either */

    dem_integrator integrator;
    dem_real dt;                   /* s; 0: chosen from the live scene, see dem_step_advice */
    int allow_large_dt;  /* 1: run even when dt exceeds t_c/20. For showing what happens */
    dem_real impact_speed;         /* m/s, typical: for linear stiffness and the time step; 0: from
                                      gravity, walls and grains (linear stiffness: 1 m/s) */
    dem_search search;
    dem_real skin;                 /* m, margin of the candidate list; 0: chosen; < 0: none, the
                                      list is rebuilt every step */
    dem_rotation rotation;         /* of bodies that are not spheres */
    dem_overlap ellipsoid_overlap;
    dem_sharing cluster_contacts;
    int orientations;              /* 1: spheres have an orientation, too */
    int ledger;                    /* 1: account for energy: dem_ledger_get */
    int threads;                   /* 0: as many as OpenMP offers; 1..64 */
    dem_allocator allocator;
} dem_world_desc;
static const dem_world_desc DEM_WORLD_DESC_ZERO = {{0, 0, 0}, {{0, 0, 0}, {0, 0, 0}},
    {DEM_BOUNDARY_OPEN, DEM_BOUNDARY_OPEN, DEM_BOUNDARY_OPEN}, 0, 0,
    DEM_NORMAL_HERTZ, DEM_TANGENT_AUTO, DEM_ROLLING_AUTO, DEM_TENSION_KEPT,
    DEM_LOAD_PUSH, DEM_SLIDER_SHARED, DEM_CONVENTION_STANDARD,
    0, 0, 0, 0, 0, 0, 0, 0, DEM_VELOCITY_VERLET, 0, 0, 0, DEM_SEARCH_AUTO, 0,
    DEM_ROTATION_SPIRAL, DEM_OVERLAP_CONSERVATIVE, DEM_SHARING_ONE, 0, 0, 0, {0, 0, 0}};
#define DEM_WORLD_DESC DEM_WORLD_DESC_ZERO

/* Creates an empty world. Returns null when a value is out of its limits or memory runs out; why is
   told by dem_create_error(desc). */
static inline dem_world *dem_world_create(const dem_world_desc *desc);
/* One sentence on why dem_world_create refuses this desc, or "" when it does not. */
DEM_API const char *dem_create_error(const dem_world_desc *desc);
DEM_API void dem_world_destroy(dem_world *world);
/* The sentence of the last failed call on this world; "" when none failed yet. Of a null world:
   that it is null. When a call that builds the scene (adds bodies, materials, shapes, walls, feeds,
   outlets, fields; sets a pair or a motion) is refused, dem_world_step and dem_world_run do not
   begin but quote it, until this function was called or the refused one went well: a scene that
   lacks its floor would run, and answer DEM_OK. A program that handles a refusal by itself and goes
   on without what was refused calls this first. */
DEM_API const char *dem_world_error(const dem_world *world);
DEM_API const char *dem_result_name(dem_result result);
/* The desc as it is in force: zeros replaced by what was chosen. */
DEM_API dem_world_desc dem_world_desc_get(const dem_world *world);

/* ---- materials ---- */
typedef struct dem_material_desc {
    dem_real density;          /* kg/m3, required, > 0 */
    dem_real young;            /* Pa, required, > 0 (for a linear law with stiffness: not needed) */
    dem_real poisson;          /* 0 <= nu < 0.5; 0 is a physical value */
    /* required, 0 < e <= 1: speed after over speed before a normal impact. Hysteretic law: either
       this or stiffness_unloading; e = sqrt(kn/kun), of a contact that does not stick */
    dem_real restitution;
    dem_real friction;         /* sliding friction mu, >= 0; 0: none */
    dem_real friction_static;  /* >= friction; 0: the same as friction */
    dem_real rolling_friction; /* mu_r, >= 0, of the effective radius; 0: none */
    /* N/m, linear and hysteretic law (there of loading); 0: from young and impact_speed [DIM04] */
    dem_real stiffness;
    dem_real stiffness_ratio;  /* kt/kn of these two laws; 0: 2(1-nu)/(2-nu) */
    dem_real stiffness_unloading; /* N/m, hysteretic law: kun >= stiffness; 0: from restitution */
    dem_real stiffness_adhesion;  /* N/m, hysteretic law: kad >= 0 ([ALK07] has it negative);
                                     0: never pulls */
} dem_material_desc;
static const dem_material_desc DEM_MATERIAL_DESC_ZERO = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
#define DEM_MATERIAL_DESC DEM_MATERIAL_DESC_ZERO

/* Adds a material. At most 64. Null id on bad values. */
DEM_API dem_material dem_material_add(dem_world *world, const dem_material_desc *desc);

/* What holds between two materials. Mixed from both when not set: restitution, friction, static
   friction, rolling friction and stiffness of adhesion by the geometric mean; moduli by Hertz (1/E*
   = sum (1-nu^2)/E, 1/G* = sum (2-nu)/G); given stiffnesses in series. Walls follow the same rule
   as grains. */
typedef struct dem_pair {
    dem_real young_eff;        /* E*, Pa */
    dem_real shear_eff;        /* G*, Pa */
    dem_real restitution, friction;
    dem_real friction_static;  /* >= friction; 0: the same as friction, and so it is when mixed from
                                  materials that leave it 0: it follows when friction is changed */
    dem_real rolling_friction;
    /* N/m, linear and hysteretic law; 0: from E* and impact speed, per pair of radii */
    dem_real stiffness;
    dem_real stiffness_ratio;  /* kt/kn, linear and hysteretic law */
    /* >= 0, factor on the tangential dashpot; 1 when mixed, 0: no dashpot */
    dem_real tangent_damping;
    dem_real stiffness_adhesion; /* N/m, hysteretic law; its kun is stiffness/restitution^2 */
    dem_real normal_damping;   /* N s/m, linear and hysteretic law: the dashpot itself, whatever the
                                  masses; 0: linear: from restitution, hysteretic: none */
} dem_pair;
DEM_API dem_result dem_pair_get(const dem_world *world, dem_material a, dem_material b,
                                dem_pair *pair);
/* Replaces what was mixed; both orders at once. */
DEM_API dem_result dem_pair_set(dem_world *world, dem_material a, dem_material b,
                                const dem_pair *pair);

/* The coefficients of the built-in laws for two radii (m); radius_b = 0: a against a wall of b. */
typedef struct dem_coefficients {
    dem_real r_eff, m_eff;     /* m, kg */
    dem_real kn, cn, kt, ct;  /* as in dem_contact: F = kn d^(3/2) + cn d^(1/4) v, or kn d + cn v */
    dem_real kun, kad;         /* N/m, hysteretic law; otherwise 0 */
    dem_real damping_ratio;    /* beta = -ln e / sqrt(pi^2 + ln^2 e) */
    dem_real contact_time;     /* s, at the world's impact speed; hysteretic law: [ALK07] eq 2.45 */
} dem_coefficients;
DEM_API dem_result dem_coefficients_get(const dem_world *world, dem_material a, dem_material b,
                                        dem_real radius_a, dem_real radius_b,
                                        dem_coefficients *out);
/* The resolved pair table, one line a pair. */
DEM_API void dem_pairs_print(const dem_world *world, FILE *out);

/* ---- grains ---- */

/* Adds a sphere (or disc) at rest. radius > 0 (m). Null id on bad values or when memory runs out.
   */
DEM_API dem_body dem_sphere_add(dem_world *world, dem_material material, dem_real radius,
                                dem_vec3 position);
/* Adds count spheres: positions (count x 3), radii (count) or null for one radius. velocities
   (count x 3) may be null. All or nothing. */
DEM_API dem_result dem_spheres_add(dem_world *world, dem_material material, int count,
                                   const dem_real *positions,
                                   const dem_real *velocities, const dem_real *radii,
                                   dem_real radius);
/* Says which places there are: not 0 for those where a body of this (bounding) radius may be. */
typedef int (*dem_inside_fn)(dem_vec3 centre, dem_real radius, void *user);
/* Where new bodies may be. */
typedef struct dem_region {
    dem_box box;             /* m, required: bodies are wholly in it. On a periodic axis a box as
                                long as the domain has no faces: centres are anywhere */
    int cylinder;            /* 'x', 'y' or 'z': in the cylinder along that axis that the box holds
                                (elliptic as the box); 0: all of the box */
    dem_inside_fn inside;    /* of those, which; 0: all */
    void *user;
} dem_region;
/* Random filling: count spheres of one radius inside box, in random sequence; seed makes it
   repeatable. A place is free when nothing there overlaps another body, across periodic faces too,
   or touches a wall: behind a plane, on the wrong side of a cylinder and in a sieve there is none;
   the inside of a closed mesh is a place like any other. Returns how many found a place (fewer than
   asked: it is too full, 2000 tries for one were in vain; the sentence says so). */
DEM_API int dem_spheres_fill(dem_world *world, dem_material material, dem_real radius,
                             dem_box box, int count,
                             uint64_t seed);
/* Hexagonal close packing of spheres with a gap of padding (m, >= 0) between surfaces, in layers
   along z: of its places those that are free, as above, and for which inside(centre, radius, user)
   is not 0 (null: all), at most count (0: all that fit). Centres keep a radius from the box, and
   across periodic faces the packing keeps off itself, but does not go on. Returns how many were
   added. */
DEM_API int dem_spheres_pack(dem_world *world, dem_material material, dem_real radius,
                             dem_real padding,
                             dem_box box, dem_inside_fn inside, void *user, int count);
DEM_API dem_result dem_body_remove(dem_world *world, dem_body body);

/* State of one body. */
struct dem_body_state {
    dem_vec3 position, velocity, spin;   /* m, m/s, rad/s */
    dem_vec3 force, torque;              /* N, N m: of the last step; ignored by dem_body_set */
    dem_real radius, mass, inertia;      /* m, kg, kg m2; ignored by dem_body_set; not a sphere: of
                                            its bounding sphere, the smallest principal moment */
    dem_material material;
    int fixed;                           /* 1: never moves, whatever pushes it */
    dem_quat orientation;  /* of the frame the shape was given in; dem_body_set: any length but 0.
                              Spheres: followed when the world desc asks for orientations */
    dem_shape shape;                     /* id 0: a sphere; ignored by dem_body_set */
    dem_vec3 moments;      /* kg m2, about the principal axes; ignored by dem_body_set */
};
DEM_API dem_result dem_body_get(const dem_world *world, dem_body body, dem_body_state *state);
/* Sets position, velocity, spin, orientation and fixed. */
DEM_API dem_result dem_body_set(dem_world *world, dem_body body, const dem_body_state *state);

/* All bodies at once, in the library's own order, which changes when the candidate list is rebuilt;
   slots tell who is who. Pointers hold until the next step or change. Stride 4: x y z and one more.
   */
typedef struct dem_bodies {
    int count;
    const dem_real *positions;  /* count x 4: x, y, z [m], (bounding) radius [m] */
    const dem_real *velocities; /* count x 4: x, y, z [m/s], 0 */
    const dem_real *spins;      /* count x 4: x, y, z [rad/s], 0 */
    /* count x 4: x, y, z [N] of contacts and force field, gravity not; 0 */
    const dem_real *forces;
    const dem_real *torques;    /* count x 4: x, y, z [N m], 0 */
    const dem_real *masses;     /* count: kg */
    /* count: slot of dem_body less 1; dem_bodies_id gives the id       */
    const uint32_t *slots;
    const int32_t *materials;   /* count: dem_material ids */
    /* count x 4: w, x, y, z, from principal axes to the world; null when no body has any */
    const dem_real *orientations;
    const int32_t *shapes;      /* count: dem_shape ids, 0: a sphere; null when all are */
} dem_bodies;
DEM_API dem_bodies dem_bodies_get(const dem_world *world);
DEM_API dem_body dem_bodies_id(const dem_world *world, int index);

/* ---- bodies that are not spheres ---- */

/* An ellipsoid with these semi-axes (m, each > 0, longest at most 1000 times the shortest) along x,
   y, z of its own frame. Null id on bad values, in a planar world or when memory runs out. */
DEM_API dem_shape dem_shape_ellipsoid_add(dem_world *world, dem_vec3 semi_axes);

typedef enum dem_cluster_mass {
    DEM_CLUSTER_UNION = 0,   /* where spheres overlap, matter counts once: ray quadrature */
    DEM_CLUSTER_SUM,         /* every sphere counts in full */
    DEM_CLUSTER_GIVEN        /* volume, centre and inertia below */
} dem_cluster_mass;
typedef struct dem_cluster_desc {
    int count;                   /* spheres, required, 1..1000 */
    const dem_real *positions;   /* count x 3, m, in a frame of your choice */
    const dem_real *radii;       /* count, m, > 0; null: all of `radius` */
    dem_real radius;             /* m */
    dem_cluster_mass mass;
    int rays;                    /* union: rays along each side of the outline, 16..4096; 0: 512 */
    dem_real volume;             /* given: m3 */
    dem_vec3 centre;             /* given: m, centre of mass in that frame */
    dem_real inertia[6];         /* given: m5, xx yy zz xy xz yz about the centre, per density;
                                    off-diagonal ones as in a tensor: -(integral of x y) */
} dem_cluster_desc;
static const dem_cluster_desc DEM_CLUSTER_DESC_ZERO = {0, 0, 0, 0, DEM_CLUSTER_UNION, 0, 0,
    {0, 0, 0}, {0, 0, 0, 0, 0, 0}};
#define DEM_CLUSTER_DESC DEM_CLUSTER_DESC_ZERO
/* A rigid cluster of spheres; its principal axes are found for you. The data is copied. Null id as
   above. */
DEM_API dem_shape dem_shape_cluster_add(dem_world *world, const dem_cluster_desc *desc);

typedef struct dem_shape_info {
    int spheres;                 /* of a cluster; 0: an ellipsoid */
    dem_real volume;             /* m3 */
    dem_vec3 centre;             /* m, centre of mass in the frame the shape was given in */
    dem_quat frame;              /* turns principal axes into that frame */
    dem_vec3 inertia;            /* m5, principal moments per density */
    dem_vec3 semi_axes;          /* m, of the ellipsoid; cluster: of the one of equal moments */
    dem_real radius;             /* m, of the smallest sphere about the centre that holds it all */
} dem_shape_info;
DEM_API dem_result dem_shape_get(const dem_world *world, dem_shape shape, dem_shape_info *info);

/* Adds a body at rest: centre of mass at position (m), turned by orientation (any length but 0)
   from the frame its shape was given in. Null id on bad values, when memory runs out, or where a
   wall does not know the shape: sieves and profiles of DEM_EDGE_FRACTION do not know ellipsoids. */
DEM_API dem_body dem_body_add(dem_world *world, dem_material material, dem_shape shape,
                              dem_vec3 position, dem_quat orientation);
/* Adds count bodies. Arrays but positions may be null: orientations (count x 4: w x y z; null: as
   given), velocities and spins (count x 3: m/s, rad/s in the world's frame; null: at rest), scales
   (count: all lengths of the shape times this, > 0; null: 1). All or nothing. */
DEM_API dem_result dem_bodies_add(dem_world *world, dem_material material, dem_shape shape,
                                  int count, const dem_real *positions,
                                  const dem_real *orientations, const dem_real *velocities,
                                  const dem_real *spins, const dem_real *scales);
/* Random filling as dem_spheres_fill, in random orientations, with room for each to turn freely. */
DEM_API int dem_bodies_fill(dem_world *world, dem_material material, dem_shape shape, dem_box box,
                            int count, uint64_t seed);
/* The same in a region; shape: null: spheres of this radius, else the radius is not used. */
DEM_API int dem_region_fill(dem_world *world, const dem_region *region, dem_material material,
                            dem_shape shape, dem_real radius, int count, uint64_t seed);

/* Two ellipsoids by themselves, for analysis. orientation: of any length; 0: not turned. */
typedef struct dem_ellipsoid { dem_vec3 position, semi_axes; dem_quat orientation; } dem_ellipsoid;
typedef struct dem_ellipsoid_contact {
    dem_real scale;              /* W0: both scaled by this touch in one point; < 1: they overlap */
    dem_real lambda;             /* 0..1, where Perram and Wertheim's function is largest */
    dem_vec3 point, normal;      /* m, where they touch; unit, from a to b */
    dem_real depth_normal, depth_chord, depth_conservative;   /* m, overlaps, see dem_overlap;
                                    < 0: apart; depth_chord then is 0 */
    int iterations;              /* evaluations it took */
} dem_ellipsoid_contact;
/* lambda: where to begin, from a contact a little while ago; 0: unknown. */
DEM_API dem_ellipsoid_contact dem_ellipsoids_contact(const dem_ellipsoid *a,
                                                     const dem_ellipsoid *b, dem_real lambda);

/* inserted = present + removed + left, always. */
typedef struct dem_balance { uint64_t inserted, present, removed, left; } dem_balance;
DEM_API dem_balance dem_balance_get(const dem_world *world);

/* ---- walls ---- */
typedef enum dem_motion_kind {
    DEM_MOTION_FIXED = 0,
    DEM_MOTION_TRANSLATING,   /* velocity */
    DEM_MOTION_ROTATING,      /* speed [rad/s] about axis through point, right-handed */
    /* displacement velocity/|velocity| * amplitude * sin(2 pi f t + phase) */
    DEM_MOTION_OSCILLATING,
    DEM_MOTION_USER           /* function */
} dem_motion_kind;
typedef struct dem_motion {
    dem_motion_kind kind;
    dem_vec3 velocity;        /* m/s (translating); direction only (oscillating) */
    dem_vec3 point, axis;  /* m, any length but 0: axis of rotation, and the one torque refers to */
    dem_real speed;           /* rad/s */
    dem_real amplitude, frequency, phase; /* m, Hz, rad */
    /* s: rotating, translating: at rest in its first pose before; default 0*/
    double start;
    dem_motion_fn function;
    void *user;
} dem_motion;
static const dem_motion DEM_MOTION_ZERO = {DEM_MOTION_FIXED, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, 0,
                                           0, 0, 0, 0, 0, 0};
#define DEM_MOTION DEM_MOTION_ZERO

/* How a wall of segments shares the force where a grain straddles two of them. */
typedef enum dem_edge_rule {
    DEM_EDGE_RESOLVED = 0,    /* as one surface, whatever the cut (>>facets): a flat one gives
                                 exactly the plane's force */
    DEM_EDGE_FRACTION         /* [MIL] Fig 5.19: every segment pushes along its own line's normal
                                 with the fraction a^2(3-2a), a = share of the chord inside.
                                 Profiles only */
} dem_edge_rule;

/* Triangles: vertices (vertex_count x 3), triangles (triangle_count x 3, counted from 0).
   Segments:  vertices (vertex_count x 2), segments  (segment_count x 2, counted from 0). */
typedef struct dem_mesh { int vertex_count, triangle_count; dem_real *vertices;
                         int32_t *triangles; } dem_mesh;
typedef struct dem_profile { int vertex_count, segment_count; dem_real *vertices;
                            int32_t *segments; } dem_profile;

/* Plane through point; grains live on the side normal points to. */
DEM_API dem_wall dem_plane_add(dem_world *world, dem_material material, dem_vec3 point,
                               dem_vec3 normal);
/* Endless cylinder about axis through point. inside = 1: grains live inside. */
DEM_API dem_wall dem_cylinder_add(dem_world *world, dem_material material, dem_vec3 point,
                                  dem_vec3 axis,
                                  dem_real radius, int inside);
/* Segments in the x-y plane drawn out along z without end; both sides push. The data is copied. */
DEM_API dem_wall dem_profile_add(dem_world *world, dem_material material,
                                 const dem_profile *profile,
                                 dem_edge_rule rule);
/* Triangles; both sides push. The data is copied. */
DEM_API dem_wall dem_mesh_add(dem_world *world, dem_material material, const dem_mesh *mesh);
/* Spheres at positions (count x 3), all of one radius, fixed to each other: [MIL]'s wall of
   particles. share (0 < share <= 1) multiplies every force: overlapping spheres stand for one
   surface. */
DEM_API dem_wall dem_grains_wall_add(dem_world *world, dem_material material, int count,
                                     const dem_real *positions,
                                     dem_real radius, dem_real share);

/* A sieve: a plane with holes, whose rows go on without end, or as far as a disc reaches. What a
   grain costs does not depend on how many holes there are. */
typedef enum dem_sieve_kind {
    DEM_SIEVE_NONE = 0,
    DEM_SIEVE_WIRES,          /* square weave of round wires */
    DEM_SIEVE_BARS,           /* parallel round wires, across `along` */
    DEM_SIEVE_SQUARE,         /* plate with square holes */
    DEM_SIEVE_ROUND,          /* plate with round holes */
    DEM_SIEVE_SLOTS,          /* plate with slots, longer along `along` */
    /* [ALK07] 4.3.3: a plane; a grain whose centre is above the reduced part of a square hole falls
       through, without touching. Cheaper, never blinded; but what passes is what clearance says */
    DEM_SIEVE_REDUCED
} dem_sieve_kind;
typedef struct dem_sieve_desc {
    dem_sieve_kind kind;      /* required */
    dem_vec3 point;           /* m, middle of a hole, half way through */
    dem_vec3 normal;          /* across the sieve; 0: along z */
    dem_vec3 along;           /* rows of holes go this way; 0, or within .05 degrees of the normal:
                                 along x, or y where x is near the normal */
    dem_real aperture;        /* m, required, > 0: clear width, side or diameter of a hole */
    dem_real bar;             /* m, required, > 0: diameter of a wire, or solid between two holes */
    dem_real length;          /* m, of slots; 0: without end */
    dem_real thickness;       /* m, of plates; 0: a sheet with sharp rims */
    dem_real lift;            /* m, between the axes of the two layers of wires; 0: in one plane,
                                 bar: laid on each other. Real wires wind between the two */
    int staggered;            /* 1: round holes in a triangular pattern */
    dem_real radius;          /* m, of the disc it is cut from; 0: without end */
    int model;                /* reduced: 1 (or 0): the whole grain above the reduced hole, 2: its
                                 centre only */
    dem_real clearance;       /* reduced: zeta of eq 4.20 or 4.21, 0 (open) to 1 (closed) */
} dem_sieve_desc;
static const dem_sieve_desc DEM_SIEVE_DESC_ZERO = {DEM_SIEVE_NONE, {0, 0, 0}, {0, 0, 0}, {0, 0, 0},
                                                   0, 0, 0, 0, 0, 0, 0, 0, 0};
#define DEM_SIEVE_DESC DEM_SIEVE_DESC_ZERO
DEM_API dem_wall dem_sieve_add(dem_world *world, dem_material material, const dem_sieve_desc *desc);
/* Grains that blind a sieve of wires or a plate: stuck in a hole, that is touching it on opposite
   sides, with the wedge between the two so narrow that friction holds it. Those moving faster than
   speed (m/s; 0: any) against the sieve are not counted. -1 with a sentence when there is no list
   of contacts (see dem_contacts_get) or the wall is no sieve. Clusters count too; reduced holes
   are never blinded. */
DEM_API int dem_sieve_blinded(const dem_world *world, dem_wall sieve, dem_real speed);

DEM_API dem_result dem_wall_motion(dem_world *world, dem_wall wall, const dem_motion *motion);
DEM_API dem_result dem_wall_pose(const dem_world *world, dem_wall wall, dem_pose *pose);
DEM_API dem_result dem_wall_remove(dem_world *world, dem_wall wall);

/* What the grains do to a wall. Torque is about the point of its motion; axial is its part along
   axis. */
typedef struct dem_wall_loads {
    dem_vec3 force;           /* N, of the last step */
    dem_vec3 torque;          /* N m, of the last step */
    dem_real torque_axial;    /* N m */
    dem_real power;           /* W, the wall gives to the grains: -(force . v + torque . w) */
    int contacts;             /* now */
    double impulse[3];        /* N s, since dem_wall_loads_reset */
    double torque_impulse;    /* N m s, of torque_axial */
    double work;              /* J, done on the grains */
    double time;              /* s, over which the last three were summed */
} dem_wall_loads;
DEM_API dem_result dem_wall_loads_get(const dem_world *world, dem_wall wall, dem_wall_loads *loads);
DEM_API dem_result dem_wall_loads_reset(dem_world *world, dem_wall wall);

/* ---- feed and outlets ---- */
enum { DEM_CLASSES = 16 };
typedef struct dem_feed { int32_t id; } dem_feed;                            /* id counts from 1 */
typedef struct dem_outlet { int32_t id; } dem_outlet;                        /* id counts from 1 */

/* Adds grains while the world runs: at random places in a region, of random sizes, at a rate, or
   all at once. A grain that finds no free place waits, and is not lost; places are found as
   dem_spheres_fill finds them. Most grains join the list of neighbours as it is; it is made anew
   for one that brings a first size or material in, or comes beside bodies that are no spheres. */
typedef struct dem_feed_desc {
    dem_material material;           /* required */
    int class_count;                 /* required, 1..16: classes of size */
    dem_real radius[DEM_CLASSES];    /* m, required */
    /* > 0, how much of each class: shares of any sum, or with `limited` grains (kg with by_mass) */
    double amount[DEM_CLASSES];
    int limited;                     /* 1: `amount` is all there is, drawn without putting back */
    int by_mass;                     /* 1: amount and rate are in kg and kg/s, not in grains */
    double rate;                     /* grains/s; 0: all at once, as far as there is room */
    double start, end;               /* s, in the world's time: a feed added later owes what was due
                                        since start; end 0: no end */
    dem_box box;                     /* m, required: centres are in it */
    int round;                       /* 1: in the upright cylinder (elliptic as the box) in it */
    dem_vec3 velocity;               /* m/s */
    dem_real spread;                 /* m/s, each component of velocity +- up to this */
    uint64_t seed;
    dem_inside_fn inside;            /* places of the box to use, as in dem_region; 0: all */
    void *inside_user;
} dem_feed_desc;
typedef struct dem_feed_state {
    uint64_t fed[DEM_CLASSES], total; /* grains */
    double mass;                      /* kg */
    uint64_t waiting;                 /* grains that are due without room; by mass, at a rate: 0 or
                                         1 */
    int done;                         /* 1: nothing more will come */
} dem_feed_state;
DEM_API dem_feed dem_feed_add(dem_world *world, const dem_feed_desc *desc);
DEM_API dem_result dem_feed_get(const dem_world *world, dem_feed feed, dem_feed_state *state);

/* Takes out grains whose centre is in a region (fixed ones too), and counts them; for the balance
   they have left. It looks whenever a new list of neighbours is made, and every 64 steps: a grain
   is in by half a skin at most, or for 64 steps, before it goes; a region thinner than half a skin
   may be passed unseen. So many that leave one by one cost hardly more than none. The radius of a
   body that is not a sphere: of the smallest sphere about its centre that holds it. */
typedef struct dem_outlet_desc {
    dem_wall frame;                  /* the region moves with this wall, which then cannot be
                                        removed; null: it stands still */
    dem_box box;                     /* m, required, in that frame */
    dem_real beyond;                 /* m, only those at least so far from the frame's z axis */
    dem_real wanted_min, wanted_max; /* m, radii that ought to leave here; max 0: no limit */
    int class_count;                 /* 0..16: classes to count by; a grain is of the nearest */
    dem_real radius[DEM_CLASSES];    /* m, ascending */
} dem_outlet_desc;
typedef struct dem_outlet_state {
    uint64_t count[DEM_CLASSES], total;
    double mass[DEM_CLASSES], total_mass;   /* kg */
    uint64_t sorted, gangue;         /* grains of the wanted radii; the others: [ALK07] s_i, g_i */
    double sorted_mass, gangue_mass; /* kg */
    double since, last;              /* s, when counting began; when the last grain left */
} dem_outlet_state;
DEM_API dem_outlet dem_outlet_add(dem_world *world, const dem_outlet_desc *desc);
DEM_API dem_result dem_outlet_get(const dem_world *world, dem_outlet outlet,
                                  dem_outlet_state *state);
/* Begins counting anew (grains that left stay in the balance). */
DEM_API dem_result dem_outlet_reset(dem_world *world, dem_outlet outlet);

/* ---------------------------------------------------------------------------------------------
   >>run
   What is done with a scene: steps, looking and measuring, files, slabs, the report.
   --------------------------------------------------------------------------------------------- */

/* ---- run ---- */

/* What limits the time step, worked out from the live scene. */
typedef struct dem_advice {
    dem_real dt;              /* s, proposed: contact_time/50, or 1/5 of the largest stable step */
    dem_real dt_max;          /* s, a larger one is refused: contact_time/20 [ALK07] eq 2.22, or
                                 the largest stable step for contacts to come (their dashpots and
                                 rolling) */
    dem_real contact_time;    /* s, of the shortest contact */
    dem_real rayleigh;        /* s, pi R sqrt(rho/G)/(.1631 nu + .8766), smallest; for comparison */
    dem_real speed;           /* m/s, impact speed assumed */
    char binds[160];          /* what binds: materials, radii, speed */
} dem_advice;
/* What contacts that are pressed already allow is looked at when the run begins, and as it goes on:
   a step that is too large for them is refused then, or made smaller where it was chosen. */
DEM_API dem_result dem_step_advice(const dem_world *world, dem_advice *advice);

/* What is likely to be wrong with a scene, found before it runs: nothing moves. */
typedef enum dem_severity {
    DEM_SEVERITY_NOTE = 1,     /* worth a look */
    DEM_SEVERITY_WARNING,      /* most likely not what was meant */
    DEM_SEVERITY_ERROR         /* it will not run, or makes no sense */
} dem_severity;
typedef struct dem_finding {
    dem_severity severity;
    char text[240];            /* one sentence: what, its value, the likely cause, the remedy */
} dem_finding;
/* Looks for grains that start inside each other or in walls, overlaps to be expected from speed and
   weight (more than 5 % of a radius, with the modulus that would keep them below 1 %), units
   (metres, kg/m3, Pa), scenes in which nothing moves or all falls for ever, walls that nothing can
   reach, a time step that is too large or needlessly small. Makes a list of neighbours. Returns how
   many findings there are, most severe first; writes at most capacity of them. */
DEM_API int dem_world_check(dem_world *world, dem_finding *findings, int capacity);
/* The same as lines of text, the first 16 of them; nothing where nothing is found. */
DEM_API int dem_check_print(dem_world *world, FILE *out);

DEM_API dem_result dem_world_step(dem_world *world, int steps);
/* Runs on for seconds, to the step nearest to the end. Runs that follow each other add up: twenty
   of 0.05 s end within half a step of 1 s, since each counts from where the one before should have
   ended (unless there were other steps between). progress, if given, is called about ten times a
   second of wall time and at the end; a non-zero answer stops the run (DEM_ERROR_STOPPED, state
   intact). */
typedef int (*dem_progress_fn)(const dem_world *world, double done, double seconds_left,
                               void *user);
DEM_API dem_result dem_world_run(dem_world *world, double seconds, dem_progress_fn progress,
                                 void *user);
/* A progress function that rewrites one line on the FILE given as user. */
DEM_API int dem_progress_print(const dem_world *world, double done, double seconds_left,
                               void *user);

DEM_API double dem_world_time(const dem_world *world);     /* s */
DEM_API uint64_t dem_world_steps(const dem_world *world);
/* 64-bit digest of positions, velocities, spins, contact memory, walls and time; equal runs, equal
   hash. */
DEM_API uint64_t dem_world_hash(const dem_world *world);

/* Counters since creation; set once, read often. */
typedef struct dem_counters {
    uint64_t steps, rebuilds;
    int candidates, contacts, wall_contacts;  /* at the last step */
    dem_real overlap_max;       /* largest overlap over the smaller radius, since the last reset */
    dem_real speed_max;         /* m/s, at the last step */
    dem_real skin;              /* m, in force */
    dem_real dt;                /* s, in force */
    dem_search search;          /* in force */
    int threads, domains;
    size_t memory;              /* bytes held */
} dem_counters;
DEM_API dem_counters dem_counters_get(const dem_world *world);
DEM_API void dem_overlap_reset(dem_world *world);

/* Where the energy went since the ledger was opened (J). stored = kinetic + rotational + elastic.
   residual = (stored - stored at opening) - gravity - walls - force - inserted + removed
            + normal + slide + tangent + rolling.
   Potential energy is in `gravity`, as work done. 0 everywhere when the ledger is off. */
typedef struct dem_ledger {
    double kinetic, rotational, elastic;          /* stored */
    double gravity, walls, force, inserted;       /* work in */
    /* dissipated: dashpot, friction, shear dashpot, rolling */
    double normal, slide, tangent, rolling;
    double removed;                               /* energy taken out with bodies */
    double throughput;                            /* sum of magnitudes of what came in */
    double residual;
} dem_ledger;
DEM_API dem_ledger dem_ledger_get(const dem_world *world);
/* Totals that cost one pass: kinetic and rotational energy (J), momentum (kg m/s), angular momentum
   about the origin (kg m2/s), centre of mass (m), mass (kg) of the bodies that can move. */
typedef struct dem_totals {
    double mass, kinetic, rotational;
    double centre[3], momentum[3], angular[3];
} dem_totals;
DEM_API dem_totals dem_totals_get(const dem_world *world);

/* ---- what accuracy costs in a scene of one's own: tried on copies of it ---- */

/* One number that a world is judged by. Averages over many grains or much time say more than
   places: where grains collide, those depend on the last bit. */
typedef double (*dem_observe_fn)(const dem_world *world, void *user);
/* m, the centre of mass above the origin: against gravity, or along z where there is none. */
DEM_API double dem_observe_height(const dem_world *world, void *user);
/* J, kinetic and rotational energy of all bodies. */
DEM_API double dem_observe_kinetic(const dem_world *world, void *user);
/* Contacts per body, those with walls included: a contact of two bodies counts for both. */
DEM_API double dem_observe_contacts(const dem_world *world, void *user);
/* N, sum over walls of the force on each. */
DEM_API double dem_observe_walls(const dem_world *world, void *user);

enum { DEM_OBSERVABLES = 8, DEM_TRIALS = 8 };
typedef struct dem_observable {
    const char *name, *unit;       /* of text that outlives the call */
    dem_observe_fn function;
    void *user;
    double scale;                  /* what it is measured by; 0: its own value in the reference */
} dem_observable;
typedef struct dem_advise_desc {
    double duration;               /* s that each trial simulates, > 0; observables are averages
                                      over its second half */
    double budget;                 /* s of wall time for all trials, as estimated from some steps of
                                      the scene, 0: 60; where it is too little they simulate less */
    double tolerance;              /* share of its scale by which an observable may be off,
                                      0: 0.02 */
    int seeds;                     /* runs of each trial, whose grains are put at most 1e-6 of a
                                      radius off; 2 .. 16; 0: 3 */
    int observable_count;          /* 0: height (its scale: above the lowest grain), kinetic energy
                                      (its scale: what there is, and what all would gain in falling
                                      by their radius), contacts */
    dem_observable observables[DEM_OBSERVABLES];
    dem_progress_fn progress;      /* called after each trial with the world asked about; or null.
                                      A non-zero answer ends the call: DEM_ERROR_STOPPED */
    void *user;
} dem_advise_desc;
static const dem_advise_desc DEM_ADVISE_DESC_ZERO = {0, 0, 0, 0, 0,
    {{0, 0, 0, 0, 0}, {0, 0, 0, 0, 0}, {0, 0, 0, 0, 0}, {0, 0, 0, 0, 0}, {0, 0, 0, 0, 0},
     {0, 0, 0, 0, 0}, {0, 0, 0, 0, 0}, {0, 0, 0, 0, 0}}, 0, 0};
#define DEM_ADVISE_DESC DEM_ADVISE_DESC_ZERO
typedef struct dem_trial {
    const char *name;              /* what differs from the scene */
    double step, stiffness;        /* factors: on the time step that the scene has, or chooses as it
                                      goes on; on all moduli and stiffnesses (normal_damping of a
                                      pair: by the root of it; steps follow contact times) */
    double dt;                     /* s, at the end */
    int done;                      /* runs that came to their end, 0 .. seeds */
    double seconds;                /* s of wall time per simulated second */
    double value[DEM_OBSERVABLES], error[DEM_OBSERVABLES];   /* mean over seeds, its error */
    double drift[DEM_OBSERVABLES]; /* from the reference, of the scale */
    double promise;                /* all observables are within this of the reference, of the
                                      scale: the largest |drift| and what chance may add (95 %
                                      for each observable); infinite when not done */
    char refusal[200];             /* why a run did not come to its end */
} dem_trial;
typedef struct dem_trials {
    int count, best;               /* best: the trial to be followed; the scene as it is: 0 */
    int reference;                 /* that with the smallest step */
    double duration, tolerance;    /* s simulated; as asked */
    int seeds, observable_count;
    dem_observable observables[DEM_OBSERVABLES];
    dem_trial trial[DEM_TRIALS];
    char advice[400];              /* what to do, and why */
} dem_trials;
/* Tries a scene with steps twice, half and a quarter as long, with grains 10 times softer and 4
   times stiffer (their steps as fine for their collisions as the scene's), and with other laws; on
   copies: the world stays as it is. Judges by observables: the advice is the cheapest trial that
   promises to be within the tolerance of the one with the smallest step. Functions of the user's
   (laws, fields, motions, regions of feeds) are asked for the copies, too, of which two at the same
   simulated time may come one after the other. What is refused: a value out of its limits, no
   bodies, a scene that would not run. */
DEM_API dem_result dem_advise(dem_world *world, const dem_advise_desc *desc, dem_trials *trials);
/* The trials as a table, and the advice. */
DEM_API void dem_trials_print(const dem_trials *trials, FILE *out);

/* Grain-grain contacts as they are now, for analysis. Calls the same law as the run, on a copy of
   the memory. Returns how many there are; fills at most capacity. -1 with a sentence when bodies or
   walls changed since the last step: dem_search_now makes a new list. */
typedef struct dem_contact_info {
    dem_body a, b;
    int32_t wall;                        /* dem_wall id when b is a wall, then b is null */
    dem_vec3 point, normal;              /* m; unit, from a to b */
    dem_real overlap;                    /* m */
    dem_vec3 force;                      /* N, on a */
} dem_contact_info;
DEM_API int dem_contacts_get(const dem_world *world, dem_contact_info *out, int capacity);
/* The candidate pairs of the present list, slots of a and b (capacity x 2). Returns how many there
   are; -1 as above. */
DEM_API int dem_candidates_get(const dem_world *world, uint32_t *out, int capacity);
/* Rebuilds the candidate list now (for tests and analysis; a run does it by itself). */
DEM_API dem_result dem_search_now(dem_world *world);

/* ---- measuring ---- */

/* A grid of cells over box on which solid fraction and velocity are averaged over a window of time.
   A grain counts where its centre is ([MIL] 5.2.9): cells smaller than grains need a long window.
   */
typedef struct dem_field_desc {
    dem_box box;              /* m */
    int cells[3];             /* >= 1 each, at most 2^28 in all */
    double start, end;        /* s; end = 0: no end */
    double interval;          /* s between samples; 0: every 100th step */
} dem_field_desc;
DEM_API dem_field dem_field_add(dem_world *world, const dem_field_desc *desc);
/* Cell (i, j, k) is at index i + cells[0]*(j + cells[1]*k). Values hold until the next step. */
typedef struct dem_field_data {
    int cells[3];
    dem_box box;
    uint64_t samples;
    /* cells: sum over samples of volume in the cell / cell volume; / samples */
    const double *solid;
    const double *mass;       /* cells: sum of kg */
    const double *momentum;   /* cells x 3: sum of kg m/s; velocity = momentum/mass */
} dem_field_data;
DEM_API dem_result dem_field_get(const dem_world *world, dem_field field, dem_field_data *data);
DEM_API dem_result dem_field_reset(dem_world *world, dem_field field);

/* ---- files ---- */

/* What is wrong with a mesh; never stops a run. */
typedef struct dem_mesh_health {
    int open_edges;           /* edges with one triangle */
    int crowded_edges;        /* edges with more than two */
    int duplicates;           /* triangles with the same three corners as an earlier one */
    int slivers;              /* height below 1e-3 of the longest side, or no area at all */
    int merged_vertices;      /* vertices at the same place, merged on reading (STL) */
    dem_box box;              /* m */
    char hint[200];           /* likely unit mistake, or "" */
} dem_mesh_health;
/* Reads triangles from [MIL]'s text format (counts; vertices; corners counted from 1), STL (text or
   binary) or OBJ, told apart by the contents. Free with dem_mesh_free. Errors name file, line and
   reason. */
DEM_API dem_result dem_mesh_read(dem_world *world, const char *path, dem_mesh *mesh,
                                 dem_mesh_health *health);
DEM_API dem_result dem_mesh_parse(dem_world *world, const char *name, const void *data,
                                  size_t size, dem_mesh *mesh,
                                  dem_mesh_health *health);
DEM_API void dem_mesh_free(dem_world *world, dem_mesh *mesh);
/* Reads segments from [MIL]'s text format in 2-D: counts; x y per vertex; two corners counted from
   1. */
DEM_API dem_result dem_profile_read(dem_world *world, const char *path, dem_profile *profile);
DEM_API dem_result dem_profile_parse(dem_world *world, const char *name, const void *data,
                                     size_t size,
                                     dem_profile *profile);
DEM_API void dem_profile_free(dem_world *world, dem_profile *profile);

/* Pictures for ParaView (VTP, legacy VTK: points with radius, velocity, spin, id, material) and
   OVITO (extended XYZ). Where bodies have orientations, these too (VTK: w x y z; XYZ: x y z w) with
   semi-axes; a cluster is one point for each of its spheres, all of its id. ParaView: Glyph, sphere
   of radius 1, scaled by semi_axes, turned by orientation (quaternion). Written to a temporary name
   and renamed, so that a file is whole or absent; links are followed, pipes refused. */
DEM_API dem_result dem_vtp_write(dem_world *world, const char *path);
DEM_API dem_result dem_vtk_write(dem_world *world, const char *path);
DEM_API dem_result dem_xyz_write(dem_world *world, const char *path);
/* Triangles of all mesh and profile walls (profiles drawn out over z0..z1) in their present pose.
   */
DEM_API dem_result dem_walls_vtp_write(dem_world *world, const char *path, dem_real z0,
                                       dem_real z1);
/* Appends the loads of a wall as one CSV line; writes the heading first when the file is new or
   empty. */
DEM_API dem_result dem_wall_loads_csv(dem_world *world, dem_wall wall, const char *path);

/* A checkpoint holds everything: bodies, walls, memory, candidate list, ledger, fields, counters.
   Reading replaces the state of a world that was created with the same desc, materials and walls
   (functions and user pointers cannot be stored), which then continues bit for bit. A file that is
   cut short, damaged, of another version or precision, or of another scene is refused by name and
   the world stays as it was. */
DEM_API dem_result dem_checkpoint_write(dem_world *world, const char *path);
DEM_API dem_result dem_checkpoint_read(dem_world *world, const char *path);

/* ---- slabs: one scene on many processors ---- */

/* How slabs in different processes reach each other; all zero: there is one process. Processes
   stand in a ring in the order of their slabs, the last below the first, and all make the same
   calls in the same order. Both functions answer 0, or anything else to stop the run.
   docs/parallel.md has them for MPI. */
typedef struct dem_transport {
    /* Sends to the process below and to the one above, receives from both; sizes in bytes, known on
       both ends. The two may be one and the same process: then what it sends up arrives from
       below. A size may be 0. */
    int (*exchange_fn)(const void *to_lower, size_t to_lower_size,
                       void *from_lower, size_t from_lower_size,
                       const void *to_upper, size_t to_upper_size,
                       void *from_upper, size_t from_upper_size, void *user);
    /* Replaces each of count values by its sum (sum = 1) or maximum (sum = 0) over processes. */
    int (*reduce_fn)(double *values, int count, int sum, void *user);
    void *user;
} dem_transport;

typedef struct dem_slabs_desc {
    int axis;                  /* 0, 1, 2: borders are planes x, y, z = const */
    int count;                 /* slabs in all, required, 1..1024; the bits of a run hang on it */
    int first, local;          /* this process holds slabs first .. first + local - 1; local = 0:
                                  all of them */
    dem_transport transport;   /* needed when some are elsewhere */
    dem_real balance;          /* borders move when the busiest slab's work is this many times the
                                  mean; 0: 1.1; < 0: borders stay where they are laid first */
    int balance_interval;      /* rebuilds from one look at the balance to the next; 0: 8 */
} dem_slabs_desc;
static const dem_slabs_desc DEM_SLABS_DESC_ZERO = {0, 0, 0, 0, {0, 0, 0}, 0, 0};
#define DEM_SLABS_DESC DEM_SLABS_DESC_ZERO

typedef struct dem_slabs dem_slabs;

/* Deals the grains of a world to slabs, which take along everything a step needs; the world itself
   stays as it is and may even be destroyed. Every process builds the same world and asks for its
   own slabs. Feeds and outlets go on in the slabs. Null on bad values or when memory runs out;
   dem_world_error(world) says why. */
DEM_API dem_slabs *dem_slabs_create(dem_world *world, const dem_slabs_desc *desc);
DEM_API void dem_slabs_destroy(dem_slabs *slabs);
DEM_API dem_result dem_slabs_step(dem_slabs *slabs, int steps);
/* Writes the state of all slabs into a world of the same scene, in every process: grains, contact
   memory, walls, loads, fields, feeds, outlets, ledger, time. The world may then be looked at,
   written, stepped, or dealt to slabs anew; the slabs go on unaware of it. It has no list of
   contacts until dem_search_now; after that it steps on as the slabs would. */
DEM_API dem_result dem_slabs_collect(dem_slabs *slabs, dem_world *world);
/* Begins the walls' sums over time and the largest overlap anew. */
DEM_API void dem_slabs_loads_reset(dem_slabs *slabs);
/* The sentence of the last failed call; "" when none failed yet. */
DEM_API const char *dem_slabs_error(const dem_slabs *slabs);

typedef struct dem_slab {
    int grains, ghosts;      /* its own; copies of the lower neighbour's */
    double lo, hi;             /* m, its borders; an outermost one is +-1e300 */
    double work;               /* counted: candidates + 4 per body, at the last rebuild */
    double seconds;            /* of wall time spent on it so far */
    uint64_t bytes;            /* sent to neighbours so far, had they been elsewhere */
} dem_slab;
/* Slabs of this process only. */
DEM_API dem_result dem_slab_get(const dem_slabs *slabs, int index, dem_slab *slab);
typedef struct dem_slabs_counters {
    double time;               /* s */
    uint64_t steps, rebuilds, border_moves;
    uint64_t migrated;         /* grains that changed slabs, those of this process */
    dem_real skin, dt;         /* m, s, in force */
} dem_slabs_counters;
DEM_API dem_slabs_counters dem_slabs_counters_get(const dem_slabs *slabs);

/* ---- report ---- */

/* Effects active and their price, time step and what binds it, search, balance, ledger. */
DEM_API void dem_world_report(const dem_world *world, FILE *out);

/* version and size of dem_real are checked against the implementation's. Use dem_world_create. */
DEM_API dem_world *dem_world_create_checked(const dem_world_desc *desc, int version,
                                            size_t real_size);
static inline dem_world *dem_world_create(const dem_world_desc *desc) {
    return dem_world_create_checked(desc, DEM_VERSION, sizeof(dem_real));
}

#ifdef __cplusplus
}
#endif
#endif /* DEM_H */

/* ================================================================================================
   >>implementation - stop here if you only want to use it
   ============================================================================================== */
#if defined(DEM_IMPLEMENTATION) && !defined(DEM_IMPLEMENTATION_DONE)
#define DEM_IMPLEMENTATION_DONE

/* ---------------------------------------------------------------------------------------------
   >>platform
   What differs between compilers lives here and nowhere else. Kernels must be inlined into their
   variants to be specialised, hence DEM_INLINE; compilers vectorise a root only when told that it
   does not set errno. There is one parallel loop, demi_parallel: it deals whole domains to threads,
   and what it calls never knows how many threads there are.
   --------------------------------------------------------------------------------------------- */
#include <float.h>
#include <limits.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#if defined(_OPENMP) && !defined(DEM_NO_OPENMP)
#include <omp.h>
#define DEMI_OPENMP 1
#else
#define DEMI_OPENMP 0
#endif

#if defined(__GNUC__) && !defined(__TINYC__)
#define DEMI_ALIGNED __attribute__((aligned(64)))           /* to a cache line */
#define DEMI_RESTRICT __restrict__
#define DEMI_FETCH(p) __builtin_prefetch(p)                 /* will be read soon */
#define DEMI_APART __attribute__((noinline))                /* keeps its registers to itself */
#define DEMI_FORMAT(f, a) __attribute__((format(printf, f, a)))
#else
#define DEMI_ALIGNED
#define DEMI_RESTRICT
#define DEMI_FETCH(p) (void)(p)
#define DEMI_APART
#define DEMI_FORMAT(f, a)
#endif
#if defined(__clang__)
#define DEMI_VECTOR                      /* clang checks for aliases itself, and warns when asked */
#elif defined(__GNUC__) && !defined(__TINYC__)
#define DEMI_VECTOR _Pragma("GCC ivdep")
#else
#define DEMI_VECTOR
#endif

/* Products and sums are rounded one by one, whatever the compiler was told. Fused, as GNU C does it
   by default where processors can, one expression gives two answers at two places, and a run that
   is interrupted another one than a run that is not. To the end of the implementation. */
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__) && !defined(__TINYC__)
#pragma GCC push_options
#pragma GCC optimize("fp-contract=off")
#endif

/* In a loop that copies: keeps compilers from making gathers of it, which are slower. */
#if defined(__GNUC__) && !defined(__TINYC__)
#define DEMI_ONE_BY_ONE(i) __asm__ __volatile__("" : "+r"(i))
#else
#define DEMI_ONE_BY_ONE(i) ((void)0)
#endif

/* Statements for 0 to 7, written out: compilers leave loops as loops at -O2. */
#define DEMI_EIGHT(DO) do { DO(0); DO(1); DO(2); DO(3); DO(4); DO(5); DO(6); DO(7); } while (0)

/* Kernels are compiled twice where that costs the user nothing: for any processor of the target,
   and for those with wider vectors, which the loader finds out. "avx2" does not bring fused
   multiplying and adding along, so both give the same bits. */
#if defined(__GNUC__) && !defined(__clang__) && defined(__GLIBC__) && defined(__x86_64__) && \
    !defined(__AVX2__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && \
    !defined(DEM_NO_CLONES)
#define DEMI_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define DEMI_CLONES
#endif

#ifndef DEM_DOMAIN_BODIES
#define DEM_DOMAIN_BODIES 2048
#endif

#define DEMI_MIN(a, b) ((a) < (b) ? (a) : (b))
#define DEMI_MAX(a, b) ((a) > (b) ? (a) : (b))
#define DEMI_PI 3.14159265358979323846

/* Calls task(world, i) for i = 0 .. count-1. Tasks must not depend on each other. */
typedef void (*demi_task)(dem_world *w, int index);
static void demi_parallel(dem_world *w, int threads, int count, demi_task task) {
    int i;
#if DEMI_OPENMP
    if (threads > 1 && count > 1) {
        #pragma omp parallel for num_threads(threads) schedule(static)
        for (i = 0; i < count; i++) task(w, i);
        return;
    }
#endif
    (void)threads;
    for (i = 0; i < count; i++) task(w, i);
}
/* Threads that a world may have when its desc leaves the number open. */
static int demi_threads_available(void) {
#if DEMI_OPENMP
    return omp_get_max_threads();
#else
    return 1;
#endif
}
static double demi_clock(void) {                          /* s of wall time, for progress only */
#if DEMI_OPENMP
    return omp_get_wtime();
#elif defined(TIME_UTC)
    struct timespec t;
    timespec_get(&t, TIME_UTC);
    return (double)t.tv_sec + 1e-9*(double)t.tv_nsec;
#else
    return (double)clock()/CLOCKS_PER_SEC;
#endif
}

/* ---------------------------------------------------------------------------------------------
   >>maths
   Small vectors by value, poses, random numbers. Finite is tested on the exponent bits, which
   -ffast-math cannot fold away.
   --------------------------------------------------------------------------------------------- */
#define DEMI_FARTHEST 1e15          /* m: coordinates beyond are mistakes; squares could overflow */
#define DEMI_LEAST 1e-12            /* m: surfaces smaller than that in all are mistakes, too */
static double demi_size(dem_vec3 a) {                     /* largest component */
    return fmax(fabs((double)a.x), fmax(fabs((double)a.y), fabs((double)a.z)));
}
static dem_vec3 demi_unit(dem_vec3 a) {                   /* of any length but 0 */
    double x = (double)a.x, y = (double)a.y, z = (double)a.z, l;
    int e;
    (void)frexp(demi_size(a), &e);                        /* a power of two: exact */
    x = ldexp(x, -e); y = ldexp(y, -e); z = ldexp(z, -e);
    l = sqrt(x*x + y*y + z*z);
    return demi_v((dem_real)(x/l), (dem_real)(y/l), (dem_real)(z/l));
}
static int demi_finite_double(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return ((bits >> 52) & 0x7ff) != 0x7ff;
}
static int demi_finite(dem_real x) { return demi_finite_double((double)x); }
static int demi_finite3(dem_vec3 v) { return demi_finite(v.x) && demi_finite(v.y) &&
                                     demi_finite(v.z); }
static int demi_place(dem_vec3 v) { return demi_finite3(v) && demi_size(v) <= DEMI_FARTHEST; }

/* local -> world and back, for points and for directions */
DEM_INLINE dem_vec3 demi_rotate(const dem_real *R, dem_vec3 a) {
    return demi_v(R[0]*a.x + R[1]*a.y + R[2]*a.z, R[3]*a.x + R[4]*a.y + R[5]*a.z, R[6]*a.x +
                  R[7]*a.y + R[8]*a.z);
}
DEM_INLINE dem_vec3 demi_unrotate(const dem_real *R, dem_vec3 a) {
    return demi_v(R[0]*a.x + R[3]*a.y + R[6]*a.z, R[1]*a.x + R[4]*a.y + R[7]*a.z, R[2]*a.x +
                  R[5]*a.y + R[8]*a.z);
}
/* Rotation by angle about a unit axis (Rodrigues), row-major. */
static void demi_rotation(double *R, double x, double y, double z, double angle) {
    double c = cos(angle), s = sin(angle), v = 1 - c;
    R[0] = c + x*x*v;   R[1] = x*y*v - z*s; R[2] = x*z*v + y*s;
    R[3] = y*x*v + z*s; R[4] = c + y*y*v;   R[5] = y*z*v - x*s;
    R[6] = z*x*v - y*s; R[7] = z*y*v + x*s; R[8] = c + z*z*v;
}
/* A rotation whose third column is the unit vector n, so that local z is n (Duff et al. 2017). */
static void demi_frame_of(dem_real *R, dem_vec3 n) {
    dem_real s = n.z >= 0 ? DEM_R(1) : DEM_R(-1), a = -1/(s + n.z), b = n.x*n.y*a;
    R[0] = 1 + s*n.x*n.x*a; R[3] = s*b;           R[6] = -s*n.x;
    R[1] = b;               R[4] = s + n.y*n.y*a; R[7] = -n.y;
    R[2] = n.x;             R[5] = n.y;           R[8] = n.z;
}

/* splitmix64: one 64-bit state, good enough to place grains. */
static uint64_t demi_random(uint64_t *state) {
    uint64_t z = (*state += UINT64_C(0x9E3779B97F4A7C15));
    z = (z ^ (z >> 30))*UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27))*UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31);
}
static double demi_uniform(uint64_t *state) {                    /* 0 <= u < 1 */
    return (double)(demi_random(state) >> 11)/9007199254740992.0;
}

/* FNV-1a, 64 bits: check sums and state hashes. */
#define DEMI_HASH_START UINT64_C(14695981039346656037)
static uint64_t demi_hash(uint64_t h, const void *data, size_t size) {
    const unsigned char *p = (const unsigned char *)data;
    size_t i;
    for (i = 0; i < size; i++) h = (h ^ p[i])*UINT64_C(1099511628211);
    return h;
}

/* ---------------------------------------------------------------------------------------------
   >>memory
   The layout of the world, and the only places where memory comes from. Bodies live in flat arrays
   of four reals each, so that a gather touches one cache line and a drift is one long loop. Every
   array that grows is a field here; DEMI_GROW keeps what it holds, or leaves it alone and says so.
   --------------------------------------------------------------------------------------------- */
enum { DEMI_MATERIALS = 64, DEMI_MEMORY = 8, DEMI_SOME = 16, DEMI_DOMAINS = 256,
      DEMI_LANES = 64/(int)sizeof(dem_real),    /* pairs computed together: widest vectors */
      DEMI_TILE = 4*DEMI_LANES };               /* pairs under work at a time */

/* Coefficients of one contact, resolved: what the built-in laws need. */
enum { DEMI_KN, DEMI_CN, DEMI_KT, DEMI_CT, DEMI_MU, DEMI_MU_STATIC, DEMI_MU_ROLL, DEMI_R_EFF,
      DEMI_K_UN, DEMI_K_AD,                     /* hysteretic law */
      DEMI_COEFS };

/* Memory that a world holds hangs on one of two chains (demi_hold): what belongs to the scene and
   outlives a restart (materials, shapes, geometry of walls), and what a run works with. */
enum { DEMI_LOOSE, DEMI_SCENE, DEMI_RUN, DEMI_CHAINS };
struct demi_block;

/* Candidate pairs of all domains. Domain d owns entries d*stride .. d*stride + stride - 1. */
typedef struct demi_list {
    int stride;                    /* capacity per domain */
    int32_t *a, *b;                /* body indices, a < b */
    int32_t *place;                /* 1 + its entry in the near list, 0 when not near */
    unsigned char *image;          /* which entry of image_shift leads from a to b */
} demi_list;

/* Near pairs of all domains: those candidates that touch or might before long. Domain d owns
   entries d*stride .. as above: pairs inside it, then, from a multiple of DEMI_LANES on, those that
   lead out. Numbers of a pair stand in columns: value e of the domain's entry p at
   memory[(d*columns + e)*stride + p]. */
typedef struct demi_near {
    int stride;                    /* capacity per domain, a multiple of DEMI_LANES */
    int32_t *a, *b, *k;            /* bodies, and their entry in the list of candidates */
    unsigned char *image;
    dem_real *memory;              /* w->memory_stride columns; zeros while a pair does not touch */
    int32_t *row;                  /* of species_coef; null where bodies are all alike, or of more
                                      species than have a table: */
    dem_real *coef;                /* then DEMI_PAIR_COLUMNS columns */
} demi_near;
enum { DEMI_M_EFF = DEMI_COEFS, DEMI_PAIR_COLUMNS };
/* Spheres alike in all that coefficients hang on. Every two of up to DEMI_SPECIES have a row of
   coefficients in a table; where there are more (radii drawn at random), near pairs have theirs. */
enum { DEMI_SPECIES = 32 };
typedef struct demi_species {
    dem_real radius, mass, inv_mass;           /* m; kg; 1/kg, 0: fixed */
    int32_t material, none;        /* 1 + index; 0, so that no byte of it is unknown */
} demi_species;

/* Sums of one domain over one step; combined in the order of domains. */
enum { DEMI_E_DASHPOT, DEMI_E_ELASTIC, DEMI_E_SHEAR_WORK, DEMI_E_SLIDE, DEMI_E_SHEAR_STORED,
      DEMI_E_ROLL,
       DEMI_E_GRAVITY, DEMI_E_FORCE, DEMI_E_WALLS, DEMI_ENERGIES };

/* Where a body touches a wall, before it is known what the law will say (see >>touch). */
typedef struct demi_touching {
    int32_t element;               /* of the wall; of facets: number of the face, edge or corner */
    dem_real overlap, share;       /* m; how often its force counts (facets: index, see >>facets) */
    dem_vec3 normal, point;        /* unit, body -> wall; m */
    dem_vec3 shift;                /* m, from the body to its image that the wall meets */
} demi_touching;
/* A side or corner of a facet that a body reaches: what joins it to its neighbours (>>touch). */
typedef struct demi_link {
    dem_real distance;             /* in the body's measure */
    int32_t number, corner;        /* of the side (corner 0) or corner (1) */
    int32_t facet;                 /* among those reached */
    int32_t sides[2];              /* of a corner: the facet's sides there */
    int32_t place;                 /* where the side is nearest: its number, or a corner's */
    int32_t root;                  /* of facet i, in link i: union and find */
    dem_real more;                 /* how much more its place counts by pieces */
    dem_vec3 point;                /* from the body's centre */
} demi_link;
/* A shape, in its principal frame, per unit of mass and scale. */
typedef struct demi_shape {
    int kind;                      /* of its parts: DEMI_BALL, ... */
    int count;                     /* spheres of a cluster; 0: it is one part */
    dem_real *parts;               /* count x 4: centre, radius, m */
    dem_vec3 axes;                 /* m, of one part: lengths as its kind has them */
    dem_vec3 inertia;              /* m2, principal moments per mass */
    double volume;                 /* m3 */
    dem_real radius;               /* m, of the bounding sphere */
    dem_real moment_arm;           /* m, how far from the centre a force may pass at most */
    dem_real thin, blunt, equal;   /* m, radii: smallest, of the flattest place, of equal volume */
    double light;                  /* share of the mass that a contact feels at least */
    dem_quat frame;                /* principal axes -> the frame it was given in */
    dem_vec3 centre;               /* m, centre of mass in that frame */
} demi_shape;

/* A contact that is kept by itself: every one but those of sphere and sphere, whose memory stands
   in the columns of the near list. Lives as long as the two touch. Within a domain they stand in
   the order of body a, pairs before walls, and that is the order in which forces are added. touch
   makes the list of a step from nothing (kept_next), each naming the one it continues among those
   of the step before (kept_now); respond takes over what is remembered and answers; then the two
   lists change places. So touch may begin anew, and nothing is lost when it runs out of room. */
typedef struct demi_kept {
    int32_t a, b;                  /* bodies (slots while there is no list); b -1: a wall */
    int32_t part_a, part_b;        /* spheres of clusters, else 0 */
    int32_t wall, element;
    int32_t send;                  /* 1 + where the force on b goes; 0: b is of this domain */
    int32_t from;                  /* which of its domain's a step ago it continues; -1: none */
    dem_vec3 normal, arm_a, arm_b; /* unit, a -> b; m, from the centres to where they push */
    dem_real overlap, deep;        /* m, 0: under way through a reduced hole; over the smallest
                                      radius */
    dem_real share, lift, grip;    /* how often it counts: damping, elastic force, friction */
    dem_real weight;               /* share before contacts are shared: see demi_kept_share */
    dem_real area, added, rate;    /* m2, A; what others add to it, over d^2; how A follows that */
    dem_real bend;                 /* 1/m: the normal turns by this times the way part_a goes */
    dem_vec3 axis;                 /* but for ways along the normal, and along this, if not 0: */
    dem_real along;                /* there by this, 1/m */
    dem_vec3 aside;                /* elastic force across the normal, over that along it */
    dem_real slope;                /* m of overlap per m of approach */
    dem_real inset;                /* the normal force passes at this part of arm_a */
    dem_real r_eff, m_eff;         /* m, kg */
    double lambda;                 /* of Perram and Wertheim, where to begin next; 0: unknown */
    dem_vec3 force;                /* N, on a */
    dem_vec3 shift;                /* with a wall: as above */
    /* what goes from step to step: respond writes it, touch does not */
    dem_real coef[DEMI_COEFS];     /* for the next two: worked out anew when they change */
    dem_real coef_r, coef_m;       /* m, kg; 0: none yet */
    dem_real memory[DEMI_MEMORY];
} demi_kept;

/* What the grains of one domain do to one wall in one step. */
typedef struct demi_wall_sum { double force[3], torque[3], power; int contacts; } demi_wall_sum;

/* A domain: bodies that stand next to each other in the arrays, since the sort has put together
   what is near. It is what one thread works on at a time, and what the order of every sum
   follows: how many domains there are, and where they begin, is told by the number of bodies
   alone. A contact belongs to the domain of its lower body; a force on a body of a later domain
   waits in a slot and is fetched there, in the order of the list. So threads change who does the
   work, never what is added to what, and bits are the same for any number of them. Lists are one
   array each, in which every domain has a stretch of its own, as long as the longest needs: no
   thread waits for another to find room, and one that runs out says so in `overflow` and is
   asked again. */
typedef struct demi_domain {
    int begin, end;                /* bodies */
    int own, cross, walls;         /* candidates: pairs inside, pairs leading out, wall elements */
    int near_own, near_cross, near_end;    /* near: end of pairs inside; begin, end of the others */
    int near_shaped, near_shaped_cross, near_shaped_end;   /* after those: pairs not of spheres */
    int near_next_own, near_next_cross, near_next_end;     /* of the list being made */
    int near_next_shaped, near_next_shaped_cross, near_next_shaped_end;
    int contacts;                  /* of bodies with bodies */
    int kept, kept_next;           /* contacts kept by themselves: now; being found */
    int kept_walls;                /* those of them with walls */
    int touching_first;            /* where its places in touching_ begin */
    int overflow;                  /* a list ran out of room while being built: 1: pairs inside, 2:
                                      pairs leading out, 4: walls, 8: near pairs, 16: kept */
    double speed2, check, overlap; /* max |v|^2, sum |v|^2, max overlap over radius, of this step */
    double acceleration2;          /* max |a|^2 */
    double turn;                   /* m/s, max change of |spin| times moment_arm in the step */
    double turn_speed;             /* m/s, max |spin| times moment_arm */
    double turn_rate;              /* rad/s, max |spin| of those that are not spheres */
    double energy[DEMI_ENERGIES];
} demi_domain;

/* Two tables, of what touches and of what is touched: nothing else names a kind but its own
   functions.

   Shapes: kinds of a body's parts (a cluster is of balls). >>add-shape: a declaration in >>scene; a
   row here, and in the rows of walls how they touch it; functions, above demi_touches. A row:
   constant; NAME; name in sentences; how far apart two parts are, the other one of this kind or of
   one above (or less than that); how the two touch, for each kind above and its own, in that order.
   The functions of that NAME: demi_NAME_support, _thin, _equal, _curve, _drawn (>>shapes says what
   they tell) and _on_wall (>>kept).

   Walls. >>add-wall: a row here, a declaration in >>scene, functions, above demi_nears. A row:
   constant; corners of an element (0: it has none); places a candidate may give at most; traits;
   name in sentences; how near a sphere is to one element; how parts touch it, by their kinds in the
   order above; how its normals turn as a ball moves (0: not at all). demi_elements_touch serves any
   wall; planes and cylinders have copies with theirs inlined.

   0, or nothing, where two do not know each other: that is said when the second of the two is
   added. All know balls. */
enum {
    DEMI_FACETS = 1,               /* a surface of facets, see >>facets */
    DEMI_DRAWN = 2,                /* drawn out along its own z without end: seen at z = 0 */
    DEMI_BALLS = 4,                /* elements are grains: balls of `radius` about their corner */
    DEMI_FLAT = 8                  /* a half space beyond z = 0 */
};
enum { DEMI_SIEVE_MOST = 25 };                  /* contacts of a grain with a sieve */
#define DEMI_SHAPES(X) \
    X(BALL,      ball,      "sphere",    demi_balls_gap,      (demi_balls_touch)) \
    X(ELLIPSOID, ellipsoid, "ellipsoid", demi_ellipsoids_gap, \
      (demi_ellipsoids_touch, demi_ellipsoids_touch)) \
    /* the last */
#define DEMI_WALLS(X) \
    X(PLANE,    0, 7, DEMI_FLAT, "plane", \
      demi_plane_near, (demi_plane_spheres, demi_plane_ellipsoid), 0) \
    X(CYLINDER, 0, 7, 0, "cylinder", \
      demi_cylinder_near, (demi_cylinder_spheres, demi_cylinder_ellipsoid), demi_cylinder_bend) \
    X(PROFILE,  2, 7, DEMI_FACETS | DEMI_DRAWN, "profile", \
      demi_facet_distance, (demi_facets_spheres, demi_facets_ellipsoid), demi_profile_bend) \
    X(SEGMENTS, 2, 7, DEMI_DRAWN, "profile of DEM_EDGE_FRACTION", \
      demi_facet_distance, (demi_segments_touch), 0) \
    X(MESH,     3, 7, DEMI_FACETS, "mesh", \
      demi_facet_distance, (demi_facets_spheres, demi_facets_ellipsoid), demi_mesh_bend) \
    X(GRAINS,   1, 7, DEMI_BALLS, "wall of grains", \
      demi_grain_near, (demi_elements_touch, demi_grain_ellipsoid), demi_grain_bend) \
    X(SIEVE,    0, DEMI_SIEVE_MOST, 0, "sieve", \
      demi_sieve_near, (demi_sieve_spheres), demi_sieve_bend) \
    /* the last */
#define DEMI_LIST(...) {__VA_ARGS__}            /* one field of a row that is a list: (a, b) */
#define DEMI_SHAPE_CONSTANT(KIND, NAME, WORD, GAP, TOUCH) DEMI_##KIND,
enum { DEMI_SHAPES(DEMI_SHAPE_CONSTANT) DEMI_SHAPE_KINDS };
#define DEMI_WALL_CONSTANT(KIND, C, M, T, N, NEAR, TOUCH, BEND) DEMI_WALL_##KIND,
enum { DEMI_WALL_NONE = 0, DEMI_WALLS(DEMI_WALL_CONSTANT) DEMI_WALL_KINDS };
typedef struct demi_wall_kind { int corners, most, traits; const char *name; } demi_wall_kind;
#define DEMI_WALL_KIND(KIND, CORNERS, MOST, TRAITS, NAME, NEAR, TOUCH, BEND) \
    {CORNERS, MOST, TRAITS, NAME},
static const demi_wall_kind demi_wall_kinds[] = {{0, 0, 0, "wall that was removed"},
    DEMI_WALLS(DEMI_WALL_KIND)};

/* A piece of a triangle's side that ends at corners of other triangles. */
typedef struct demi_cut {
    dem_vec3 a, b;
    dem_real weight;               /* what it counts; 0: another facet looks after it */
    int32_t number, end[2];        /* of the piece: the edge's where it is one; of its ends */
    int32_t side;                  /* of the element */
} demi_cut;

typedef struct demi_wall {
    int kind, material;            /* DEMI_WALL_..., index */
    int inside;                    /* cylinder */
    dem_edge_rule rule;
    dem_real radius, share;        /* cylinder; grains */
    dem_sieve_desc sieve;
    int vertex_count, element_count;
    dem_real *vertices;            /* vertex_count x 3, in the wall's own frame */
    int32_t *corners;              /* element_count x 3 (mesh), x 2 (profile) */
    /* surfaces of facets (mesh, profile), see >>facets */
    int edge_count, cut_count, number_count;   /* numbers: of faces, edges, corners, cuts */
    int32_t *edges;                /* element_count x 3 (mesh): the edge from corner k to k + 1 */
    dem_real *weight;              /* how often each face, edge and corner counts, in this order */
    unsigned char *owns;           /* element_count: bit k: looks after edge k, 3 + k: corner k */
    dem_real *planes;              /* element_count x 4: unit normal and n.x of its plane, m; zeros:
                                      it is too thin to have one */
    dem_real plane_slack;          /* m, what rounding may do to a distance from a plane */
    int32_t *cut_start;            /* element_count + 1 (null: none): pieces of edges in `cuts` */
    demi_cut *cuts;
    int group;                     /* walls of one group do not move against each other */
    int lone;                      /* its facets have neighbours of its own alone */
    dem_real span_lo[3], span_hi[3];   /* m, from where to where it goes, in a periodic world */
    int repeats[3];                /* along a periodic axis: it is not longer than the period */
    dem_real extent;               /* m, farthest vertex from the frame's origin; < 0: endless */
    dem_pose home, pose;           /* pose at motion start, pose now */
    dem_pose first;                /* as it was added */
    dem_pose mid;                  /* in the middle of the step just taken */
    dem_motion motion;
    int symmetric;                 /* its motion leaves its surface in place: no search needed */
    dem_box box;                   /* local box of the elements */
    int cells[3];                  /* local grid of elements; 0: none */
    dem_real cell;                 /* m */
    int32_t *cell_start, *cell_items;
    int cell_item_count;
    dem_wall_loads loads;
} demi_wall;

typedef struct demi_field {
    int used;
    dem_field_desc desc;
    uint64_t samples;
    double next;                   /* s, time of the next sample */
    double *solid, *mass, *momentum;
} demi_field;

typedef struct demi_feed {
    dem_feed_desc desc;
    dem_feed_state state;
    uint64_t random;
    uint64_t limit[DEM_CLASSES];   /* grains of each class, when limited */
    double mass[DEM_CLASSES];      /* kg, of a grain */
    int64_t next;                  /* class of the next grain, -1: not drawn yet */
    uint64_t again;                /* step at which one that found no room tries again */
} demi_feed;
typedef struct demi_outlet { dem_outlet_desc desc; dem_outlet_state state; } demi_outlet;

/* One level of the hierarchical grid: the bodies of a class of radii, and cells of their own. */
typedef struct demi_level {
    double radius;                 /* m, largest of the class */
    double size[3];                /* m, of a cell */
    int cells[3], first;           /* cells stand from `first` on in w->cell_start */
    int count;                     /* bodies */
} demi_level;
/* classes of radii a factor sqrt 2 wide, before they are joined */
enum { DEMI_LEVELS = 24 };

/* Steps of one length: time is counted from their beginning, so that rounding does not add up. */
typedef struct demi_since { double time; uint64_t steps; double dt; } demi_since;

/* Box ends of the linked linear list on one axis. */
typedef struct demi_end { dem_real value; int32_t box; int32_t upper; } demi_end;

/* What holds between two materials. */
typedef struct demi_pair {
    dem_pair given;
    double damping;                /* damping ratio that gives its restitution */
} demi_pair;

/* The laws in force and where the memory of each begins (that of friction: at 0), see >>laws. */
struct demi_law_row;
typedef struct demi_laws {
    const struct demi_law_row *normal, *tangent, *rolling;
    int at_rolling, at_normal, memory, vectors;     /* reals; bits of those that are vectors */
} demi_laws;

/* --- what a world knows in numbers alone, by whose they are. Saved and copied whole: a field more
       is saved, too. Pointers, and what follows from other things, do not belong here. --- */

typedef struct demi_timing {       /* >>step, >>advice */
    double time;                   /* s: since.time + (steps - since.steps) since.dt */
    demi_since since;              /* when the present dt came into force */
    uint64_t steps, rebuilds;
    uint64_t last_rebuild;         /* step */
    double run_end;                /* s: where the last run should have ended, */
    uint64_t run_steps;            /* and the step at which it did */
    dem_real dt;                   /* s */
    double half_kick;              /* s, of the step under way */
    double assumed_speed;          /* m/s, behind dt */
    double spin_elsewhere;         /* rad/s, fastest in slabs, of bodies that are not spheres */
    uint64_t press_due;            /* step at which what presses bodies is looked for next */
    uint64_t press_since;          /* step of the last change of the scene */
} demi_timing;
/* How far a world has got on its way to the next step. A change of the scene undoes dt_valid,
   forces_valid and primed; one of who is where, list_valid, too. dem_world_step makes good what is
   missing, in this order: */
typedef struct demi_stages {
    int dt_valid;                  /* 1: the time step suits the scene */
    int list_valid;                /* 2: candidates fit the bodies */
    int pairs_changed;             /* 0, or 1: what holds between materials has changed since */
    int forces_valid;              /* 3: forces are those of the present places and velocities */
    int primed;                    /* 4: half-step velocities are those of the step before */
    int moved;                     /* a step has moved and lacks its forces: memory ran out in it */
    int synced;                    /* no half kick is due: see demi_finish */
    int near_stale;                /* the near list lacks a pair of a body that joined */
    /* a rebuild or a new near list that ran out of memory had chosen these: tried again, it takes
       the same, since the counts they are chosen by may be gone */
    int skin_chosen, near_chosen;
} demi_stages;
typedef struct demi_margin {       /* >>rebuild, >>near: how long lists hold */
    double skin, gone, walls_gone; /* m: margin, farthest a body / a wall point went since */
    double step_gone;              /* m, farthest that any point of a body went in the last step */
    double skin_auto;              /* m: what the cost model proposes; 0: nothing yet */
    double span, age;              /* s: how long the near list is meant to last, lasts already */
    double slack;                  /* m: what velocities may bring by having changed since */
    double change, last_change;    /* m/s: most that a velocity may have changed since; last step */
    double creep;                  /* m: what that may have brought two bodies together */
} demi_margin;
typedef struct demi_in_force {     /* >>rebuild: worked out when the list is made */
    int tangent, rolling;          /* laws in force */
    int uniform;                   /* one radius, one mass, one material, nothing fixed */
    int fixed_count;
    int tight;                     /* some body is so long that its bounding sphere is no guide */
    int species_count;             /* DEMI_SPECIES + 1: more than that */
    demi_species species[DEMI_SPECIES];
    dem_real radius_min, radius_max;           /* m */
} demi_in_force;
typedef struct demi_levels {       /* >>search */
    int count, wide;               /* wide: radii differ so much that levels pay */
    demi_level level[DEMI_LEVELS]; /* the coarsest first; none in use: count is 0 */
    double fine;                   /* m, largest radius of the finest class */
    double tests[2];               /* estimated work of a search per body: by one grid, by levels */
} demi_levels;
typedef struct demi_booked {       /* >>ledger: sums since the beginning, and the largest seen */
    double energy[DEMI_ENERGIES], inserted, removed, throughput;       /* J */
    double overlap_max, speed_max; /* of the radius; m/s */
} demi_booked;

/* Bodies: who they are (slots, which never move) and where they stand in the arrays (indices, which
   change whenever the list is rebuilt). Part >>bodies owns them; integrators move them, contacts
   push them. What is done with each array: demi_body_arrays. */
typedef struct demi_bodies {
    int count, capacity;           /* bodies */
    dem_real *pos, *vel, *spin;    /* x 4; at the full step (predicted while a step is under way) */
    dem_real *half_vel, *half_spin;/* x 4; mean over the step just taken: at the half step */
    dem_real *last_pos;            /* x 4; one step ago (schemes that look back) */
    dem_real *force, *torque;      /* x 4 */
    dem_real *inv_mass, *inv_inertia, *mass;     /* inv_inertia: 0 unless a sphere that moves */
    int backward;                  /* last_pos exists */
    int orienting;                 /* the next four exist */
    dem_real *orient;              /* x 4: w x y z, principal axes -> world */
    dem_real *angular;             /* x 4: angular momentum at the half step; shaped bodies only */
    dem_real *moment;              /* x 4: principal moments of inertia, kg m2; moment_arm, m */
    int32_t *shape;                /* dem_shape ids; 0: a sphere */
    int shaped;                    /* bodies that are not spheres */
    dem_real *centre;              /* x 4: spheres of clusters: centre from the body's, radius, m */
    int32_t *centre_start;           /* where those of each body begin */
    int centres_valid;               /* they fit the bodies and their orientations */
    uint32_t *slot;                /* of each body: who it is */
    int32_t *material;             /* 1 + index */
    int32_t *slot_index;           /* slot -> index, -1 when free */
    uint32_t *slot_generation;
    int slot_count, slot_capacity; /* slots used so far, room */
    /* chains of free slots (-1: none); pending ones rest until a rebuild */
    int slot_free, slot_pending;
    uint8_t *ghost;              /* by slot; null outside >>slabs: 1: a copy, owned elsewhere */
    dem_real *scratch;             /* x 4, for permuting */
    int32_t *order, *cell_of;      /* permutation, cell of each body */
    dem_balance balance;
} demi_bodies;
/* The road of a contact's memory. While a list holds, memory of two spheres stands in columns of
   the near list, beside its pair; every other contact carries its own (demi_kept). A near list
   that is made anew takes columns over from the one before, pair by pair (near_last). Before a
   search, and when bodies come or go (demi_list_drop), indices are about to change: memory of
   spheres is filed here, by slot, and kept contacts name slots instead of indices. The next list
   fetches what is filed (demi_near_make), kept contacts move to the domains of their bodies
   (demi_kept_move), and what turns round on the way, because a body has got the lower index,
   changes its sign where it is a vector. Nothing is thrown away before all of the new list has
   its room: a rebuild that is refused memory can be asked for again. A checkpoint writes
   whatever of this there is. Entries start[row] .. start[row + 1] - 1 belong to the row, the
   pair's lower slot. */
typedef struct demi_filed {
    int32_t *start;                /* rows + 2 */
    int32_t *partner;              /* the higher slot; ~ of it when body a of the pair was that */
    dem_real *memory;              /* x stride */
    int count, rows;               /* entries; slots there were when they were filed */
    int stride;                    /* reals per entry */
} demi_filed;

/* A world, by owners: each part writes its own, all read. Where more write, they are named. */
struct dem_world {
    /* >>world */
    dem_world_desc desc;           /* as given, with choices filled in */
    dem_world_desc asked;          /* as given */
    /* >>memory: sentences (demi_fail), and all that was allocated */
    char error[512];
    char refusal[512];             /* of the first call that builds the scene and was refused */
    int refused;                   /* calls that were, since dem_world_error was read */
    char refused_calls[24][32];    /* their names */
    size_t bytes;
    struct demi_block *chains[DEMI_CHAINS];
    /* numbers alone, saved and copied whole */
    demi_timing clock;             /* >>step; dt and what hangs on it: >>advice */
    demi_stages stage;             /* undone by whoever changes the scene, made good by >>step */
    demi_margin margin;            /* skin: >>rebuild; the near list's: >>near; gone: >>step */
    demi_in_force effects;         /* >>rebuild */
    demi_levels levels;            /* >>search */
    demi_booked booked;            /* >>ledger; what comes and goes: >>bodies, >>feed, >>step */
    /* >>materials */
    int material_count;
    dem_material_desc materials[DEMI_MATERIALS];
    demi_pair *pairs;              /* DEMI_MATERIALS x DEMI_MATERIALS */
    /* >>shapes */
    int shape_count;
    demi_shape *shapes;
    /* >>bodies; moved by >>integrators, pushed by >>respond and >>kept */
    demi_bodies bodies;
    demi_filed filed;
    /* >>walls; weights of facets: >>facets; poses and loads: >>step */
    int wall_count;
    demi_wall *walls;
    double wall_fastest;           /* m/s, fastest wall point of the step */
    dem_real wall_period[3], ring_period[3];   /* m, of walls; of a ring of slabs */
    int repeating;                 /* does any wall repeat? */
    int facets_valid;              /* what facets count fits the walls and their motions */
    /* >>measure, >>feed, >>placing, >>advice */
    int field_count;
    demi_field *fields;
    int feed_count, outlet_count;
    demi_feed *feeds;
    demi_outlet *outlets;
    struct demi_sphere *crowd;
    struct demi_node *crowd_nodes;
    dem_real *crowd_turned;        /* x 4 */
    double dt_share;               /* trials: of the step that would be chosen; 0: all of it */
    struct demi_press *press;      /* what presses bodies, while a step is judged */
    struct demi_press_whole *press_whole;
    /* >>rebuild: laws in force, domains */
    int normal;                    /* law in force */
    demi_laws laws;                /* their rows; not used where the user's own acts */
    int memory_stride, vector_mask;/* reals per contact; which of them are vectors */
    int composed;                  /* one stage per law even where one for all would do (tests) */
    int domain_count;
    demi_domain *domains;          /* counts of each list by who makes it */
    /* >>search */
    dem_real image_shift[27*4];    /* m, from a body to another's image; 0: none */
    int32_t *cell_start;
    int cells[3];
    double cell_origin[3], cell_size[3];
    demi_end *lll_ends[3];
    struct demi_pair_key *lll_table;
    int32_t *lll_rows, *lll_row_start;
    int lll_valid, lll_boxes, lll_size;
    /* >>lists: candidates of pairs and on walls; contacts that last */
    demi_list own, cross;
    int join_room;                 /* candidates that newcomers may bring, see demi_list_join */
    int *cross_incoming_start;     /* domain_count + 1 */
    int32_t *cross_incoming;       /* entries of `cross`, by domain of b, ascending */
    dem_real *cross_force;          /* x 6: force and torque on the far end */
    int cross_entries;
    int wall_stride;               /* wall candidates per domain */
    int32_t *wall_body, *wall_id, *wall_element;
    dem_real *wall_gap;            /* m, between grain and element when the list was made, or a
                                      little less */
    dem_real *wall_shift;          /* x 3, m: from the grain to its image that is near */
    demi_wall_sum *wall_sums;      /* domain_count x wall_count */
    int touching_valid;            /* the next three have room for the present candidates */
    demi_touching *touching;       /* of one body and wall, by domain */
    int32_t *touching_table;
    demi_link *touching_links;
    int kept_first[DEMI_DOMAINS + 1];   /* where those of domain d begin, in either list */
    demi_kept *kept_now, *kept_next;
    /* >>near */
    demi_near near, near_last;     /* in use, and the one before: swapped when made anew */
    dem_real *species_coef;        /* row a*species_count + b: DEMI_PAIR_COLUMNS of species a and b;
                                      as they were when lists were made */
    int species_vary;              /* columns that are not the same for all near pairs: 1 << each */
    struct demi_quiet *quiet;      /* what may push each few bodies, see demi_domain_quiet */
    int near_fresh, near_due;      /* being made after a search; slabs: some list is due */
    /* >>respond */
    void (*kernel)(dem_world *w, int domain);
};

/* --- what each body has, told once. Making room, adding, removing, sorting, checking, saving and
       sending to another slab are loops over these rows (>>bodies). >>add-array: a field in
       demi_bodies above and a row here. Who has it: DEMI_EVERY body; DEMI_BACK: those of a scheme
       that looks back; DEMI_TURNED: those of a world where bodies turn; DEMI_SLOTS: every slot.
       What is done with it: DEMI_KEPT: it is state, and 0 in a new body unless set; DEMI_REALS:
       kept, and finite; DEMI_PLACES: reals that begin with a place, which moves by a period; 0:
       room to work in. --- */
enum { DEMI_EVERY, DEMI_BACK, DEMI_TURNED, DEMI_SLOTS };
enum { DEMI_KEPT = 1, DEMI_REALS = 3, DEMI_PLACES = 7 };
typedef struct demi_body_array {
    size_t field, item;            /* where its pointer stands in demi_bodies; bytes of one body */
    int who, what;
} demi_body_array;
#define DEMI_ARRAY(field, count, who, what) \
    {offsetof(demi_bodies, field), (count)*sizeof *((demi_bodies *)0)->field, who, what}
static const demi_body_array demi_body_arrays[] = {
    DEMI_ARRAY(slot,            1, DEMI_EVERY,  DEMI_KEPT),     /* the first: see demi_body_take */
    DEMI_ARRAY(material,        1, DEMI_EVERY,  DEMI_KEPT),
    DEMI_ARRAY(pos,             4, DEMI_EVERY,  DEMI_PLACES),
    DEMI_ARRAY(vel,             4, DEMI_EVERY,  DEMI_REALS),
    DEMI_ARRAY(spin,            4, DEMI_EVERY,  DEMI_REALS),
    DEMI_ARRAY(half_vel,        4, DEMI_EVERY,  DEMI_REALS),
    DEMI_ARRAY(half_spin,       4, DEMI_EVERY,  DEMI_REALS),
    DEMI_ARRAY(force,           4, DEMI_EVERY,  DEMI_REALS),
    DEMI_ARRAY(torque,          4, DEMI_EVERY,  DEMI_REALS),
    DEMI_ARRAY(mass,            1, DEMI_EVERY,  DEMI_REALS),
    DEMI_ARRAY(inv_mass,        1, DEMI_EVERY,  DEMI_REALS),
    DEMI_ARRAY(inv_inertia,     1, DEMI_EVERY,  DEMI_REALS),
    DEMI_ARRAY(last_pos,        4, DEMI_BACK,   DEMI_PLACES),
    DEMI_ARRAY(orient,          4, DEMI_TURNED, DEMI_REALS),
    DEMI_ARRAY(angular,         4, DEMI_TURNED, DEMI_REALS),
    DEMI_ARRAY(moment,          4, DEMI_TURNED, DEMI_REALS),
    DEMI_ARRAY(shape,           1, DEMI_TURNED, DEMI_KEPT),
    DEMI_ARRAY(scratch,         4, DEMI_EVERY,  0),
    DEMI_ARRAY(order,           1, DEMI_EVERY,  0),
    DEMI_ARRAY(cell_of,         1, DEMI_EVERY,  0),
    DEMI_ARRAY(slot_index,      1, DEMI_SLOTS,  DEMI_KEPT),
    DEMI_ARRAY(slot_generation, 1, DEMI_SLOTS,  DEMI_KEPT)};
enum { DEMI_BODY_ARRAYS = (int)(sizeof demi_body_arrays/sizeof *demi_body_arrays) };

/* Does a call, its name n characters long, build a scene? Without what it would have added or
   chosen a run is another one. Those that take away, look, read or write do not. */
static int demi_builds(const char *call, size_t n) {
    static const char *const ends[] = {"_add", "_fill", "_pack", "dem_pair_set", "dem_wall_motion"};
    size_t k, l;
    for (k = 0; k < sizeof ends/sizeof *ends; k++) {
        l = strlen(ends[k]);
        if (n >= l && !memcmp(call + n - l, ends[k], l)) return 1;
    }
    return 0;
}
/* Which of the refused calls it is, -1: none. */
static int demi_refused_find(const dem_world *w, const char *call, size_t n) {
    int k;
    for (k = 0; k < w->refused; k++)
        if (strlen(w->refused_calls[k]) == n && !memcmp(w->refused_calls[k], call, n)) return k;
    return -1;
}

static dem_result demi_fail(dem_world *w, dem_result result, const char *format,
                            ...) DEMI_FORMAT(3, 4);
static dem_result demi_fail(dem_world *w, dem_result result, const char *format, ...) {
    const size_t calls = sizeof w->refused_calls/sizeof *w->refused_calls;
    va_list args;
    size_t n;
    va_start(args, format);
    vsnprintf(w->error, sizeof w->error, format, args);
    va_end(args);
    n = strcspn(w->error, ":");
    if (n >= sizeof *w->refused_calls || !demi_builds(w->error, n)) return result;
    if (!w->refused) memcpy(w->refusal, w->error, sizeof w->refusal);
    if (demi_refused_find(w, w->error, n) < 0 && (size_t)w->refused < calls) {
        memcpy(w->refused_calls[w->refused], w->error, n);
        w->refused_calls[w->refused++][n] = 0;
    }
    return result;
}
/* A call that builds the scene went well: an earlier refusal of the same call is made good. */
static void demi_built(dem_world *w, const char *call) {
    const size_t n = strlen(call);
    const int k = demi_refused_find(w, call, n);
    if (k < 0) return;
    memmove(w->refused_calls[k], w->refused_calls[k + 1],
            (size_t)(--w->refused - k)*sizeof *w->refused_calls);
    if (!w->refused || strncmp(w->refusal, call, n) || w->refusal[n] != ':') return;
    snprintf(w->refusal, sizeof w->refusal, "%s: was refused, too", w->refused_calls[0]);
}
/* Before a run: says so when a call that builds the scene was refused and nobody read why. A scene
   that lacks something would run, and answer DEM_OK. */
static dem_result demi_unbuilt(dem_world *w, const char *call) {
    char why[sizeof w->refusal];
    if (!w->refused) return DEM_OK;
    memcpy(why, w->refusal, sizeof why);
    return demi_fail(w, DEM_ERROR_ARGUMENT, "%s: not begun, because a call before was refused and "
                     "nobody has read why: \"%.320s\"; mend that call, or read dem_world_error "
                     "and go on without it", call, why);
}
/* 1, with a sentence where there is a world to hold it, when the world or a pointer that has to
   lead somewhere is null: the first line of every public function asks. */
static int demi_null(const dem_world *w, const char *call, const void *pointer, const char *name) {
    if (w && pointer) return 0;
    if (w) demi_fail((dem_world *)w, DEM_ERROR_ARGUMENT, "%s: %s is null; give its address", call,
                     name);
    return 1;
}
static const dem_material demi_no_material = {0};
static const dem_shape demi_no_shape = {0};
static const dem_body demi_no_body = {0, 0};
static const dem_wall demi_no_wall = {0};
static const dem_field demi_no_field = {0};
static const dem_feed demi_no_feed = {0};
static const dem_outlet demi_no_outlet = {0};

static dem_result demi_no_memory(dem_world *w, const char *call) {
    return demi_fail(w, DEM_ERROR_MEMORY, "%s: out of memory with %.1f MB held; use fewer bodies "
                     "or a smaller skin; nothing was changed", call, (double)w->bytes/1e6);
}

static void *demi_raw_alloc(const dem_allocator *a, size_t size) {
    return a->alloc_fn ? a->alloc_fn(size, a->user) : malloc(size);
}
static void demi_raw_free(const dem_allocator *a, void *p, size_t size) {
    if (!p) return;
    if (a->free_fn) a->free_fn(p, size, a->user); else free(p);
}
/* What stands before everything handed out. Begins on a cache line, so that no row of four reals
   lies across two; knows its size, so that it frees and grows without being told. */
typedef struct demi_block {
    struct demi_block *before, *after;         /* in its chain */
    size_t bytes;                              /* of what is handed out */
    int in, chain;                             /* bytes from where the allocator's begin */
} demi_block;
enum { DEMI_LINE = 64 };
static demi_block *demi_block_of(void *data) { return (demi_block *)data - 1; }
/* Items of `item` bytes there is room for; 0 of null. */
static size_t demi_room(const void *data, size_t item) {
    return data ? ((const demi_block *)data - 1)->bytes/item : 0;
}
/* count items of size bytes, cleared, that hang on a chain of the world or, DEMI_LOOSE, on none:
   then its maker frees it. Null when there is no room, the product overflows, or count is 0. */
static void *demi_hold(dem_world *w, int chain, size_t count, size_t size) {
    const size_t bytes = count*size;
    unsigned char *p;
    demi_block *block;
    int in;
    if ((size && count > (size_t)-1/2/size) || !bytes) return 0;
    p = (unsigned char *)demi_raw_alloc(&w->desc.allocator, bytes + 2*DEMI_LINE);
    if (!p) return 0;
    in = 2*DEMI_LINE - (int)((uintptr_t)p%DEMI_LINE);
    memset(p + in, 0, bytes);
    block = (demi_block *)(void *)(p + in) - 1;
    block->before = 0;
    block->after = chain ? w->chains[chain] : 0;
    block->bytes = bytes;
    block->in = in;
    block->chain = chain;
    if (block->after) block->after->before = block;
    if (chain) w->chains[chain] = block;
    w->bytes += bytes + 2*DEMI_LINE;
    return p + in;
}
static void *demi_alloc(dem_world *w, size_t count, size_t size) {
    return demi_hold(w, DEMI_LOOSE, count, size);
}
static void demi_free(dem_world *w, void *data) {
    demi_block *block;
    if (!data) return;
    block = demi_block_of(data);
    if (block->after) block->after->before = block->before;
    if (block->before) block->before->after = block->after;
    else if (block->chain) w->chains[block->chain] = block->after;
    w->bytes -= block->bytes + 2*DEMI_LINE;
    demi_raw_free(&w->desc.allocator, (unsigned char *)data - block->in,
                  block->bytes + 2*DEMI_LINE);
}
/* All that hangs on a chain: nothing can be forgotten. */
static void demi_free_chain(dem_world *w, int chain) {
    while (w->chains[chain]) demi_free(w, w->chains[chain] + 1);
}
/* Makes room for count items in an array of the world, keeping those there; never shrinks. An array
   grown for none is not null either, for null + 0 is undefined in C. 0 when memory ran out; then
   nothing has changed. */
#define DEMI_GROW(w, array, count) demi_grow(w, DEMI_RUN, &(array), sizeof *(array), count)
static int demi_grow(dem_world *w, int chain, void *array, size_t item, size_t count) {
    void *old, *fresh;
    size_t room;
    memcpy(&old, array, sizeof old);            /* a pointer to whatever */
    room = demi_room(old, item);
    if (old && count <= room) return 1;
    /* bulk: what it takes; bit by bit: in steps */
    fresh = demi_hold(w, chain, DEMI_MAX(count, room + room/4 + 16), item);
    if (!fresh) return 0;
    if (old) memcpy(fresh, old, room*item);
    demi_free(w, old);
    memcpy(array, &fresh, sizeof fresh);
    return 1;
}

/* ---------------------------------------------------------------------------------------------
   >>laws
   The built-in laws, a line each: the laws themselves stand in >>api, where those who write their
   own may call them. A contact force is made of a normal law, one of friction and one of rolling,
   of which the last two may be absent. What is kept per contact is what these keep, one after the
   other: friction, rolling, normal; each says which of it are vectors.
   >>add-law: (1) a function dem_law_... and, at the end of its enum, a constant in >>api; (2) a
   line at the end of its list here, which says what it asks for besides (DEMI_SIZED, DEMI_MIDDLE),
   for a normal law with its coefficients above; (3) a sentence in tests/. docs/extending.md
   performs it, and `make recipes` performs docs/extending.md.
   --------------------------------------------------------------------------------------------- */
/* What the rest of dem.h must know of a law. */
enum {
    DEMI_LINEAR = 0,               /* force ~ overlap; a stiffness that is given may be its own */
    DEMI_HERTZIAN = 1,             /* force ~ overlap^(3/2), stiffness ~ sqrt(R) */
    DEMI_BRANCHED = 2,             /* unloads along another line, and may adhere: kun, kad */
    DEMI_MIDDLE = 4,               /* asks for slopes or kt_step, which others find to be NaN */
    DEMI_SPRUNG = 8,               /* rolling that the time step must resolve */
    DEMI_SIZED = 16                /* asks for r_eff or m_eff, which others find to be NaN */
};
/* What a normal law's coefficients are made of: moduli (Pa), radius (m), mass (kg), damping ratio
   of one contact, and the speed (m/s) of a likely impact. M: kg, the mass that a stiffness may
   follow: it stays as it is while two bodies touch, where m turns with a body that is no sphere;
   a stiffness that did so would make energy (up to 0.1 of an impact's). */
typedef struct demi_scales {
    double E, G, R, m, M, beta, speed;
    const dem_pair *pair;
} demi_scales;
typedef struct demi_coefs { double kn, cn, kt, ct, kun, kad; } demi_coefs;
/* F = kn d^(3/2) + cn d^(1/4) v,  kn = 4/3 E* sqrt(R*),  cn = 2 sqrt(5/6) beta sqrt(2 E* sqrt(R*)
   m*),  kt = 8 G* sqrt(R*) (times d^(1/2)),  ct = 2 sqrt(5/6) beta sqrt(8 G* sqrt(R*) m*)
   [TSU92, MIL] */
static void demi_coefs_hertz(const demi_scales *s, demi_coefs *k) {
    const double root = sqrt(s->R);
    k->kn = 4*s->E*root/3;
    k->cn = 2*sqrt(5.0/6)*s->beta*sqrt(2*s->E*root*s->m);
    k->kt = 8*s->G*root;
    k->ct = 2*sqrt(5.0/6)*s->beta*sqrt(8*s->G*root*s->m);
}
/* F = kn d + cn v,  kn = (320/81 M v^2 E*^4 R*^2)^(1/5) [DIM04] unless given,
   cn = 2 beta sqrt(kn m*) unless given,  kt = ratio kn,  ct = 2 beta sqrt(kt m*) */
static void demi_coefs_linear(const demi_scales *s, demi_coefs *k) {
    const double E = s->E, R = s->R, m = s->m, M = s->M, v = s->speed;
    const dem_pair *p = s->pair;
    k->kn = p->stiffness > 0 ? (double)p->stiffness : pow(320.0/81*M*v*v*E*E*E*E*R*R, 0.2);
    k->cn = p->normal_damping > 0 ? (double)p->normal_damping : 2*s->beta*sqrt(k->kn*m);
    k->kt = k->kn*(double)p->stiffness_ratio;
    k->ct = 2*s->beta*sqrt(k->kt*m);
}
/* kn, kt, ct as linear,  kun = kn/e^2 ([ALK07] eq 2.43),  kad as given,  cn = 0 unless given */
static void demi_coefs_hysteretic(const demi_scales *s, demi_coefs *k) {
    const double e = (double)s->pair->restitution;
    demi_coefs_linear(s, k);
    k->cn = (double)s->pair->normal_damping;
    k->kun = k->kn/(e*e);
    k->kad = (double)s->pair->stiffness_adhesion;
}
/* constant, function, reals of memory, how many vectors they begin with, what is to be known, name
   in reports; the coefficients of a normal law are demi_coefs_... */
#define DEMI_NORMAL_LAWS(X) \
    X(DEM_NORMAL_HERTZ,             hertz,            0, 0, DEMI_HERTZIAN, "Hertz") \
    X(DEM_NORMAL_LINEAR,            linear,           0, 0, DEMI_LINEAR, "linear") \
    X(DEM_NORMAL_HYSTERETIC,        hysteretic,       1, 0, DEMI_BRANCHED, "hysteretic") \
    /* the last */
#define DEMI_TANGENT_LAWS(X) \
    X(DEM_TANGENT_VISCOUS,          viscous,          0, 0, 0, "viscous") \
    X(DEM_TANGENT_STEP,             step,             0, 0, 0, "step") \
    X(DEM_TANGENT_SPRING,           spring,           3, 1, 0, "spring") \
    X(DEM_TANGENT_MINDLIN,          mindlin,          4, 1, DEMI_MIDDLE, "Mindlin") \
    X(DEM_TANGENT_MINDLIN_RESCALED, mindlin_rescaled, 4, 1, DEMI_MIDDLE, "Mindlin, rescaled") \
    /* the last */
#define DEMI_ROLLING_LAWS(X) \
    X(DEM_ROLLING_STEP,             roll_step,        0, 0, DEMI_SIZED, "step") \
    X(DEM_ROLLING_CONSTANT,         roll_constant,    3, 1, DEMI_SIZED, "constant torque") \
    X(DEM_ROLLING_EPSD,             roll_epsd,        3, 1, \
      DEMI_SPRUNG | DEMI_SIZED | DEMI_MIDDLE, "EPSD") \
    /* the last */

typedef struct demi_law_row {
    int kind;                      /* the constant: its place in the table */
    dem_law_fn law;                /* null: none, or "chosen for you" */
    int memory, vectors, traits;
    const char *name;
    void (*coefs)(const demi_scales *s, demi_coefs *k);    /* of a normal law; k: zeros before */
} demi_law_row;
#define DEMI_NORMAL_ROW(KIND, LAW, MEMORY, VECTORS, TRAITS, NAME) \
    {KIND, dem_law_##LAW, MEMORY, VECTORS, TRAITS, NAME, demi_coefs_##LAW},
#define DEMI_LAW_ROW(KIND, LAW, MEMORY, VECTORS, TRAITS, NAME) \
    {KIND, dem_law_##LAW, MEMORY, VECTORS, TRAITS, NAME, 0},
static const demi_law_row demi_normal_laws[] = {DEMI_NORMAL_LAWS(DEMI_NORMAL_ROW)
    {-1, 0, 0, 0, 0, 0, 0}};
static const demi_law_row demi_tangent_laws[] = {{DEM_TANGENT_AUTO, 0, 0, 0, 0, "auto", 0},
    {DEM_TANGENT_NONE, 0, 0, 0, 0, "none", 0}, DEMI_TANGENT_LAWS(DEMI_LAW_ROW)
    {-1, 0, 0, 0, 0, 0, 0}};
static const demi_law_row demi_rolling_laws[] = {{DEM_ROLLING_AUTO, 0, 0, 0, 0, "auto", 0},
    {DEM_ROLLING_NONE, 0, 0, 0, 0, "none", 0}, DEMI_ROLLING_LAWS(DEMI_LAW_ROW)
    {-1, 0, 0, 0, 0, 0, 0}};
/* Which law is meant where the choice is left to us. */
static int demi_tangent_meant(const dem_world *w) {
    return w->desc.tangent_law == DEM_TANGENT_AUTO ? DEM_TANGENT_SPRING : (int)w->desc.tangent_law;
}
static int demi_rolling_meant(const dem_world *w) {
    return w->desc.rolling_law == DEM_ROLLING_AUTO ? DEM_ROLLING_EPSD : (int)w->desc.rolling_law;
}
/* Has the normal law that the desc asks for such a trait? */
DEM_INLINE int demi_normal_is(const dem_world *w, int trait) {
    return (demi_normal_laws[w->desc.normal_law].traits & trait) != 0;
}
/* Does a law in force ask for r_eff or m_eff of pairs? */
static int demi_laws_sized(const dem_world *w) {
    return w->desc.law || ((w->laws.normal->traits | w->laws.tangent->traits |
                            w->laws.rolling->traits) & DEMI_SIZED);
}
/* Does one ask for slopes of the normal force, or for the stiffness amid the step? */
static int demi_laws_precise(const dem_world *w) {
    return ((w->laws.tangent->traits | w->laws.rolling->traits) & DEMI_MIDDLE) != 0;
}
/* Is there such a law in a table? */
static int demi_law_known(const demi_law_row *rows, int kind) {
    int k;
    for (k = 0; rows[k].kind >= 0; k++) if (k == kind) return 1;
    return 0;
}

/* The laws in force, and where the memory of each begins. */
static void demi_laws_set(demi_laws *laws, int normal, int tangent, int rolling) {
    laws->normal = &demi_normal_laws[normal];
    laws->tangent = &demi_tangent_laws[tangent];
    laws->rolling = &demi_rolling_laws[rolling];
    laws->at_rolling = laws->tangent->memory;
    laws->at_normal = laws->at_rolling + laws->rolling->memory;
    laws->memory = laws->at_normal + laws->normal->memory;
    laws->vectors = ((1 << 3*laws->tangent->vectors) - 1) |
                    ((1 << 3*laws->rolling->vectors) - 1) << laws->at_rolling |
                    ((1 << 3*laws->normal->vectors) - 1) << laws->at_normal;
}
/* An answer before its law is called. Number by number: a memset would keep the struct in memory,
   and loops from becoming vector code. */
DEM_INLINE void demi_force_clear(dem_contact_force *f) {
    f->tangent = f->moment = demi_v(0, 0, 0);
    f->normal = f->elastic = f->load = f->slope = f->slope_step = 0;
    f->kt = f->kt_step = f->ct = 0;
    f->energy.dashpot = f->energy.sag = f->energy.elastic = f->energy.shear_work = 0;
    f->energy.slide = f->energy.shear_stored = f->energy.roll = 0;
}
/* What the desc says about how dashpots meet the end of a contact and friction's limit; what it
   says where nothing is asked for. */
DEM_INLINE void demi_contact_usual(dem_contact *c) {
    c->tension = DEM_TENSION_KEPT;
    c->friction_load = DEM_LOAD_PUSH;
    c->slider = DEM_SLIDER_SHARED;
}
static int demi_laws_usual(const dem_world *w) {
    return w->desc.tension == DEM_TENSION_KEPT && w->desc.friction_load == DEM_LOAD_PUSH &&
           w->desc.slider == DEM_SLIDER_SHARED;
}
DEM_INLINE void demi_contact_choices(const dem_world *w, dem_contact *c) {
    c->tension = (int)w->desc.tension;
    c->friction_load = (int)w->desc.friction_load;
    c->slider = (int)w->desc.slider;
}
/* The force of one contact by the laws in force, or by the user's. */
static void demi_law(const dem_world *w, const dem_contact *c, dem_real *memory,
                     dem_contact_force *f) {
    const demi_laws *laws = &w->laws;
    demi_force_clear(f);
    if (w->desc.law) { w->desc.law(c, memory, f); return; }
    laws->normal->law(c, memory + laws->at_normal, f);
    if (laws->tangent->law) laws->tangent->law(c, memory, f);
    if (laws->rolling->law) laws->rolling->law(c, memory + laws->at_rolling, f);
}

/* ---------------------------------------------------------------------------------------------
   >>materials
   Users say what a material is (density, Young's modulus, Poisson's ratio, restitution, friction);
   the pair table says what holds between two; demi_coefficients turns a pair and two radii into the
   numbers a law multiplies with. Restitution comes first, damping is derived from it.
   --------------------------------------------------------------------------------------------- */
static dem_result demi_material_check(dem_world *w, const char *call, const dem_material_desc *d) {
    const int linear_k = !demi_normal_is(w, DEMI_HERTZIAN) && d->stiffness > 0;
    /* restitution may then be left to the two stiffnesses */
    const int two_k = demi_normal_is(w, DEMI_BRANCHED) && d->stiffness_unloading > 0;
    struct { const char *name; dem_real value; int ok; const char *limit; } rows[11];
    int i;
#define DEMI_ROW(k, field, good, text) \
    rows[k].name = #field; rows[k].value = d->field; rows[k].ok = (good); rows[k].limit = text
    DEMI_ROW(0, density, d->density > 0, "> 0 kg/m3 (required)");
    DEMI_ROW(1, young, d->young > 0 || (linear_k && DEMI_ABS(d->young) <= 0), "> 0 Pa (required)");
    DEMI_ROW(2, poisson, d->poisson >= 0 && d->poisson < DEM_R(0.5), ">= 0 and < 0.5");
    DEMI_ROW(3, restitution, (d->restitution > 0 || (two_k && DEMI_ABS(d->restitution) <= 0)) &&
             d->restitution <= 1, "> 0 and <= 1 (required)");
    DEMI_ROW(4, friction, d->friction >= 0, ">= 0");
    DEMI_ROW(5, friction_static, DEMI_ABS(d->friction_static) <= 0 ||
             d->friction_static >= d->friction,
             "0 or at least the sliding friction");
    DEMI_ROW(6, rolling_friction, d->rolling_friction >= 0, ">= 0");
    DEMI_ROW(7, stiffness, d->stiffness >= 0, ">= 0 N/m");
    DEMI_ROW(8, stiffness_ratio, d->stiffness_ratio >= 0, ">= 0");
    DEMI_ROW(9, stiffness_unloading, DEMI_ABS(d->stiffness_unloading) <= 0 ||
             (d->stiffness > 0 && d->stiffness_unloading >= d->stiffness),
             "0 or at least the stiffness of loading, which is to be given then, in N/m");
    DEMI_ROW(10, stiffness_adhesion, d->stiffness_adhesion >= 0, ">= 0 N/m (its size, not its "
             "slope)");
#undef DEMI_ROW
    for (i = 0; i < 11; i++)
        if (!rows[i].ok || !demi_finite(rows[i].value))
            return demi_fail(w, DEM_ERROR_ARGUMENT, "%s: %s is %g, must be %s; set it in the desc "
                             "before the call",
                             call, rows[i].name, (double)rows[i].value, rows[i].limit);
    if (two_k && d->restitution > 0 && fabs((double)d->restitution*(double)d->restitution*
        (double)d->stiffness_unloading/(double)d->stiffness - 1) > 1e-3)
        return demi_fail(w, DEM_ERROR_ARGUMENT, "%s: restitution is %g, but sqrt(stiffness/"
                         "stiffness_unloading) is %g; give one of the two and leave the other 0",
                         call, (double)d->restitution,
                         sqrt((double)d->stiffness/(double)d->stiffness_unloading));
    return DEM_OK;
}

/* One pair from two materials: Hertz's series of compliances for the moduli, geometric means for
   the rest. */
static dem_pair demi_mix(const dem_material_desc *a, const dem_material_desc *b) {
    dem_pair p;
    const double Ea = (double)a->young, Eb = (double)b->young, na = (double)a->poisson;
    const double nb = (double)b->poisson;
    const int sticks = a->friction_static > 0 || b->friction_static > 0;
    const double sa = (double)(a->friction_static > 0 ? a->friction_static : a->friction);
    const double sb = (double)(b->friction_static > 0 ? b->friction_static : b->friction);
    memset(&p, 0, sizeof p);
    if (Ea > 0 && Eb > 0) {
        p.young_eff = (dem_real)(1/((1 - na*na)/Ea + (1 - nb*nb)/Eb));
        p.shear_eff = (dem_real)(1/((2 - na)*2*(1 + na)/Ea + (2 - nb)*2*(1 + nb)/Eb));
    }
    p.restitution = (dem_real)sqrt((double)a->restitution*(double)b->restitution);
    p.friction = (dem_real)sqrt((double)a->friction*(double)b->friction);
    p.friction_static = sticks ? (dem_real)sqrt(sa*sb) : 0;   /* 0: follows the sliding one */
    p.rolling_friction = (dem_real)sqrt((double)a->rolling_friction*(double)b->rolling_friction);
    p.tangent_damping = 1;
    p.stiffness_adhesion =
        (dem_real)sqrt((double)a->stiffness_adhesion*(double)b->stiffness_adhesion);
    /* springs in series; equal materials: their own value */
    if (a->stiffness > 0 && b->stiffness > 0)
        p.stiffness = 2*a->stiffness*b->stiffness/(a->stiffness + b->stiffness);
    /* one has a modulus only, the other a stiffness only */
    else if (p.young_eff <= 0)
        p.stiffness = DEMI_MAX(a->stiffness, b->stiffness);
    if (a->stiffness_ratio > 0 && b->stiffness_ratio > 0)
        p.stiffness_ratio = DEMI_SQRT(a->stiffness_ratio*b->stiffness_ratio);
    else                                        /* Mindlin's ratio 2(1-nu)/(2-nu), of the mean nu */
        p.stiffness_ratio = (dem_real)(2*(1 - (na + nb)/2)/(2 - (na + nb)/2));
    return p;
}

/* beta = -ln e / sqrt(pi^2 + ln^2 e), the share of critical damping that gives restitution e */
static double demi_damping_ratio(double e) {
    const double l = log(e);
    return -l/sqrt(DEMI_PI*DEMI_PI + l*l);
}
/* Restitution of a dashpot of `beta` times the critical when the contact ends at zero force [SP07]:
   exp(-beta/w acos(2 beta^2 - 1)), w = sqrt(1 - beta^2); beyond the critical by hyperbolic
   functions. Holds for the linear law and, with [TSU92]'s dashpot, for Hertz. */
static double demi_restitution_clipped(double beta) {
    const double w = sqrt(fabs(1 - beta*beta));
    if (beta < 1 - 1e-9) return exp(-beta/w*acos(2*beta*beta - 1));
    if (beta > 1 + 1e-9) return exp(-beta/w*log((beta + w)/(beta - w)));
    return exp(-2.0);
}
/* The share of critical damping that gives restitution e, as tension is treated. */
static double demi_damping_for(double e, dem_tension tension) {
    double lo = 0, hi = 1;
    int i;
    if (tension != DEM_TENSION_NONE || e >= 1) return demi_damping_ratio(e);
    while (demi_restitution_clipped(hi) > e && hi < 1e6) hi *= 2;
    for (i = 0; i < 100; i++) {                 /* falls with beta */
        const double mid = (lo + hi)/2;
        if (demi_restitution_clipped(mid) > e) lo = mid;
        else hi = mid;
    }
    return (lo + hi)/2;
}

/* What holds between two materials, in both orders; the damping that gives their restitution is
   worked out here, once, since it takes a search (algorithm at demi_damping_for). */
static void demi_pair_put(dem_world *w, int i, int j, const dem_pair *p) {
    demi_pair *pair = &w->pairs[i*DEMI_MATERIALS + j];
    pair->given = *p;
    pair->damping = demi_damping_for((double)p->restitution, w->desc.tension);
    w->pairs[j*DEMI_MATERIALS + i] = *pair;
}
/* Unset, or below the sliding one, it follows that. */
static dem_real demi_static_friction(const dem_world *w, int a, int b) {
    const dem_pair *p = &w->pairs[a*DEMI_MATERIALS + b].given;
    return DEMI_MAX(p->friction, p->friction_static);
}
DEM_API dem_material dem_material_add(dem_world *w, const dem_material_desc *desc) {
    if (demi_null(w, "dem_material_add", desc, "desc")) return demi_no_material;
    dem_material id; int i, n = w->material_count;
    id.id = 0;
    if (demi_material_check(w, "dem_material_add", desc) != DEM_OK) return id;
    if (n == DEMI_MATERIALS) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "dem_material_add: there are %d materials already, the "
                  "limit; reuse one", n);
        return id;
    }
    w->materials[n] = *desc;
    if (!(desc->restitution > 0))               /* hysteretic law: left to the stiffnesses */
        w->materials[n].restitution = DEMI_SQRT(desc->stiffness/desc->stiffness_unloading);
    w->material_count = n + 1;
    for (i = 0; i <= n; i++) {
        const dem_pair pair = demi_mix(&w->materials[i], &w->materials[n]);
        demi_pair_put(w, i, n, &pair);
    }
    demi_built(w, "dem_material_add");
    id.id = n + 1;
    return id;
}

/* From the id that a user holds to an index, or a sentence in the name of `call`. */
static dem_result demi_material_index(dem_world *w, const char *call, dem_material m, int *index) {
    if (m.id < 1 || m.id > w->material_count)
        return demi_fail(w, DEM_ERROR_ARGUMENT, "%s: material %d does not exist, there are %d; add "
                         "it with dem_material_add and check what that returned", call, (int)m.id,
                         w->material_count);
    *index = m.id - 1;
    return DEM_OK;
}

DEM_API dem_result dem_pair_get(const dem_world *world, dem_material a, dem_material b,
                                dem_pair *pair) {
    if (demi_null(world, "dem_pair_get", pair, "pair")) return DEM_ERROR_ARGUMENT;
    dem_world *w = (dem_world *)world;          /* only the error sentence is written */
    int i = 0, j = 0;
    if (demi_material_index(w, "dem_pair_get", a, &i) ||
        demi_material_index(w, "dem_pair_get", b, &j))
        return DEM_ERROR_ARGUMENT;
    *pair = w->pairs[i*DEMI_MATERIALS + j].given;
    return DEM_OK;
}

DEM_API dem_result dem_pair_set(dem_world *w, dem_material a, dem_material b, const dem_pair *p) {
    if (demi_null(w, "dem_pair_set", p, "pair")) return DEM_ERROR_ARGUMENT;
    int i = 0, j = 0;
    const char *bad = 0, *limit = "";
    dem_real value = 0;
    if (demi_material_index(w, "dem_pair_set", a, &i) ||
        demi_material_index(w, "dem_pair_set", b, &j))
        return DEM_ERROR_ARGUMENT;
#define DEMI_BAD(field, good, text) \
    if (!bad && (!demi_finite(p->field) || !(good))) { \
        bad = #field; value = p->field; limit = text; \
    }
    DEMI_BAD(young_eff, p->young_eff > 0 || (p->young_eff >= 0 && p->stiffness > 0 &&
             !demi_normal_is(w, DEMI_HERTZIAN)), "> 0 Pa")
    DEMI_BAD(shear_eff, p->shear_eff >= 0, ">= 0 Pa")
    DEMI_BAD(restitution, p->restitution > 0 && p->restitution <= 1, "> 0 and <= 1")
    DEMI_BAD(friction, p->friction >= 0, ">= 0")
    DEMI_BAD(friction_static, DEMI_ABS(p->friction_static) <= 0 ||
             p->friction_static >= p->friction,
             "0, to be the same as the sliding friction, or at least that")
    DEMI_BAD(rolling_friction, p->rolling_friction >= 0, ">= 0")
    DEMI_BAD(stiffness, p->stiffness >= 0, ">= 0 N/m")
    DEMI_BAD(stiffness_ratio, p->stiffness_ratio >= 0, ">= 0")
    DEMI_BAD(tangent_damping, p->tangent_damping >= 0, ">= 0")
    DEMI_BAD(stiffness_adhesion, p->stiffness_adhesion >= 0, ">= 0 N/m")
    DEMI_BAD(normal_damping, p->normal_damping >= 0, ">= 0 N s/m")
#undef DEMI_BAD
    if (bad)
        return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_pair_set: %s of materials %d and %d is %g, "
                         "must be %s; start "
                         "from dem_pair_get and change what differs", bad, i + 1, j + 1,
                         (double)value, limit);
    demi_pair_put(w, i, j, p);
    w->stage.pairs_changed = 1;                       /* the next step makes a new list of it */
    demi_built(w, "dem_pair_set");
    w->stage.dt_valid = 0;
    return DEM_OK;
}

/* The coefficients of one contact: its law's (>>laws), and what holds for all.
   DEM_CONVENTION_MILL keeps the thesis's habits: E* = E of one body, 8 G of one body, half overlaps
   between grains (folded into the coefficients here), R/2 and m/2 against walls. r_eff, m_eff: the
   standard ones; stiff: kg, what a stiffness follows. Checked by "the thesis's eight coefficients".
   */
static void demi_coefficients(const dem_world *w, int a, int b, double r_eff, double m_eff,
                              double stiff, int wall, dem_real *out) {
    const dem_pair *p = &w->pairs[a*DEMI_MATERIALS + b].given;
    const int mill = w->desc.convention == DEM_CONVENTION_MILL;
    demi_scales s = {(double)p->young_eff, (double)p->shear_eff, r_eff, m_eff, stiff, 0, 1, p};
    demi_coefs k = {0, 0, 0, 0, 0, 0};
    s.beta = w->pairs[a*DEMI_MATERIALS + b].damping;
    if (w->desc.impact_speed > 0) s.speed = (double)w->desc.impact_speed;
    if (mill) {  /* material b's own moduli: the wall's, or the grain's */
        const dem_material_desc *d = &w->materials[b];
        s.E = (double)d->young;
        s.G = s.E/(2*(1 + (double)d->poisson));
        if (wall) { s.R /= 2; s.m /= 2; s.M /= 2; }
    }
    demi_normal_laws[w->desc.normal_law].coefs(&s, &k);
    if (mill && !wall && demi_normal_is(w, DEMI_HERTZIAN)) {   /* of half the overlap */
        k.kn *= pow(0.5, 1.5); k.kt *= sqrt(0.5);
        k.cn *= pow(0.5, 0.25); k.ct *= pow(0.5, 0.25);
    }
    k.ct *= (double)p->tangent_damping;
    out[DEMI_KN] = (dem_real)k.kn; out[DEMI_CN] = (dem_real)k.cn;
    out[DEMI_KT] = (dem_real)k.kt; out[DEMI_CT] = (dem_real)k.ct;
    out[DEMI_K_UN] = (dem_real)k.kun; out[DEMI_K_AD] = (dem_real)k.kad;
    out[DEMI_MU] = p->friction;
    out[DEMI_MU_STATIC] = demi_static_friction(w, a, b);
    out[DEMI_MU_ROLL] = p->rolling_friction;
    out[DEMI_R_EFF] = (dem_real)r_eff;
}

/* Duration of an undamped contact at an impact speed: Hertz 2.94327518 delta_max/v, linear pi
   sqrt(m/k) (with damping pi/sqrt(k/m - (c/2m)^2) [ALK07] eq 2.21; near the critical damping and
   beyond, where that has no end, pi 2m/c: the dashpot's own time). Branched: that of its
   steepest branch, kun, which is what a time step has to follow; the contact itself lasts longer,
   eq 2.45. */
static double demi_contact_time(const dem_world *w, const dem_real *coef, double m_eff,
                                double speed) {
    const int branched = demi_normal_is(w, DEMI_BRANCHED);
    const double k = (double)coef[branched ? DEMI_K_UN : DEMI_KN], c = (double)coef[DEMI_CN];
    if (!demi_normal_is(w, DEMI_HERTZIAN)) {
        const double eta = c/(2*m_eff);
        return DEMI_PI/DEMI_MAX(sqrt(DEMI_MAX(k/m_eff - eta*eta, 0)), eta);
    }
    return 2.94327518*pow(5*m_eff*speed*speed/(4*k), 0.4)/speed;
}

static double demi_sphere_mass(const dem_world *w, int material, double r) {
    const double rho = (double)w->materials[material].density;
    if (w->desc.planar) return rho*DEMI_PI*r*r*(double)w->desc.thickness;
    return rho*4/3*DEMI_PI*r*r*r;
}
static double demi_sphere_inertia(const dem_world *w, double mass, double r) {
    return w->desc.planar ? mass*r*r/2 : 0.4*mass*r*r;
}

/* 1 with a sentence when a sphere or disc of this radius would have a mass or moment of inertia
   that dem_real cannot hold, or not the inverse of: what moves it would be 0 or infinite. */
static int demi_mass_refuse(dem_world *w, const char *call, int material, dem_real radius, int i) {
    const double r = (double)radius, m = demi_sphere_mass(w, material, r);
    const double inertia = demi_sphere_inertia(w, m, r);
    const dem_real four[] = {(dem_real)m, (dem_real)(1/m), (dem_real)inertia,
                             (dem_real)(1/inertia)};
    int k, bad = !demi_finite_double(m) || !(m > 0) || !demi_finite_double(inertia) ||
        !(inertia > 0) || r > DEMI_FARTHEST;
    for (k = 0; k < 4 && !bad; k++) bad = !demi_finite(four[k]) || !(four[k] > 0);
    if (bad)
        demi_fail(w, DEM_ERROR_ARGUMENT, "%s: radius of number %d is %g m, which gives it a mass "
                  "of %g kg: too small or too large to calculate with in %s precision; lengths are "
                  "in metres: check the unit; nothing was added", call, i, r, m,
                  DEMI_SINGLE ? "single" : "double");
    return bad;
}

DEM_API dem_result dem_coefficients_get(const dem_world *world, dem_material a, dem_material b,
                                        dem_real radius_a, dem_real radius_b,
                                        dem_coefficients *out) {
    if (demi_null(world, "dem_coefficients_get", out, "out")) return DEM_ERROR_ARGUMENT;
    dem_world *w = (dem_world *)world;
    int i = 0, j = 0;
    double ra = (double)radius_a, rb = (double)radius_b, ma, r, m;
    dem_real coef[DEMI_COEFS];
    if (demi_material_index(w, "dem_coefficients_get", a, &i) ||
        demi_material_index(w, "dem_coefficients_get", b, &j))
        return DEM_ERROR_ARGUMENT;
    if (!(ra > 0) || !(rb >= 0) || !demi_finite(radius_a) || !demi_finite(radius_b))
        return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_coefficients_get: radii are %g and %g m, must "
                         "be > 0 and >= 0 "
                         "(0: a wall)", ra, rb);
    ma = demi_sphere_mass(w, i, ra);
    r = rb > 0 ? ra*rb/(ra + rb) : ra;
    m = rb > 0 ? 1/(1/ma + 1/demi_sphere_mass(w, j, rb)) : ma;
    demi_coefficients(w, i, j, r, m, m, rb <= 0, coef);
    out->r_eff = (dem_real)r; out->m_eff = (dem_real)m;
    out->kn = coef[DEMI_KN]; out->cn = coef[DEMI_CN]; out->kt = coef[DEMI_KT];
    out->ct = coef[DEMI_CT];
    out->kun = coef[DEMI_K_UN]; out->kad = coef[DEMI_K_AD];
    out->damping_ratio = (dem_real)w->pairs[i*DEMI_MATERIALS + j].damping;
    out->contact_time = (dem_real)demi_contact_time(w, coef, m, w->desc.impact_speed > 0
                                                    ? (double)w->desc.impact_speed : 1);
    if (demi_normal_is(w, DEMI_BRANCHED))
        out->contact_time = (dem_real)(DEMI_PI/2*(sqrt(m/(double)out->kn) +
                                                  sqrt(m/(double)out->kun)));
    return DEM_OK;
}

DEM_API void dem_pairs_print(const dem_world *w, FILE *out) {
    if (demi_null(w, "dem_pairs_print", out, "out")) return;
    int i, j;
    fprintf(out, "pair       E* [Pa]      G* [Pa]      e      mu     mu_s   mu_r   k [N/m]    "
            "kt/kn\n");
    for (i = 0; i < w->material_count; i++)
        for (j = i; j < w->material_count; j++) {
            const dem_pair *p = &w->pairs[i*DEMI_MATERIALS + j].given;
            fprintf(out, "%2d - %-2d  %12.6g %12.6g  %-6.4g %-6.4g %-6.4g %-6.4g %-10.4g %.4g\n",
                    i + 1, j + 1,
                    (double)p->young_eff, (double)p->shear_eff, (double)p->restitution,
                    (double)p->friction,
                    (double)DEMI_MAX(p->friction, p->friction_static),
                    (double)p->rolling_friction, (double)p->stiffness,
                    (double)p->stiffness_ratio);
        }
}

/* ---------------------------------------------------------------------------------------------
   >>shapes
   What a body is when it is not a sphere: an ellipsoid, or a rigid cluster of spheres. A shape is
   kept in its principal frame, its centre of mass at the origin, per unit of mass and of the body's
   scale; a body has a position, a quaternion and, as its radius, that of its bounding sphere, which
   tells its scale. Here are mass properties, how far a body reaches in a direction, and where two
   ellipsoids meet. Knows no material and no law.
   --------------------------------------------------------------------------------------------- */
DEM_API dem_quat dem_quat_about(dem_vec3 axis, dem_real angle) {
    const dem_vec3 e = demi_unit(axis);
    const dem_real s = (dem_real)sin((double)angle/2);
    return dem_quat_make((dem_real)cos((double)angle/2), s*e.x, s*e.y, s*e.z);
}
static dem_quat demi_quat_at(const dem_real *p) { return dem_quat_make(p[0], p[1], p[2], p[3]); }
static void demi_quat_put(dem_real *p, dem_quat q) {
    p[0] = q.w; p[1] = q.x; p[2] = q.y; p[3] = q.z;
}
static dem_quat demi_quat_conjugate(dem_quat q) { return dem_quat_make(q.w, -q.x, -q.y, -q.z); }
static int demi_quat_finite(dem_quat q) {
    return demi_finite(q.w) && demi_finite(q.x) && demi_finite(q.y) && demi_finite(q.z);
}
/* The largest of its components. */
static double demi_quat_most(dem_quat q) {
    const double a = fabs((double)q.w), b = fabs((double)q.x), c = fabs((double)q.y);
    const double d = fabs((double)q.z), ab = DEMI_MAX(a, b), cd = DEMI_MAX(c, d);
    return DEMI_MAX(ab, cd);
}
/* Made a unit one; not for zero. */
static dem_quat demi_quat_unit(dem_quat q) {
    const double most = demi_quat_most(q);      /* first: squares may be too large or small */
    const double w = (double)q.w/most, x = (double)q.x/most, y = (double)q.y/most;
    const double z = (double)q.z/most, l = sqrt(w*w + x*x + y*y + z*z);
    return dem_quat_make((dem_real)(w/l), (dem_real)(x/l), (dem_real)(y/l), (dem_real)(z/l));
}
/* Of the rotation whose matrix has these columns (Shepperd): the largest component comes first, so
   that nothing small is divided by. */
static dem_quat demi_quat_of(double R[3][3]) {
    const double t = R[0][0] + R[1][1] + R[2][2];
    double q[4];
    int i = 0, j, k;
    if (t > R[0][0] && t > R[1][1] && t > R[2][2]) {
        q[0] = 1 + t;
        q[1] = R[2][1] - R[1][2]; q[2] = R[0][2] - R[2][0]; q[3] = R[1][0] - R[0][1];
    } else {
        if (R[1][1] > R[i][i]) i = 1;
        if (R[2][2] > R[i][i]) i = 2;
        j = (i + 1)%3;
        k = (i + 2)%3;
        q[0] = R[k][j] - R[j][k];
        q[1 + i] = 1 + R[i][i] - R[j][j] - R[k][k];
        q[1 + j] = R[j][i] + R[i][j];
        q[1 + k] = R[k][i] + R[i][k];
    }
    return demi_quat_unit(dem_quat_make((dem_real)q[0], (dem_real)q[1], (dem_real)q[2],
                                        (dem_real)q[3]));
}

/* --- mass properties --- */

/* Eigenvalues of a symmetric matrix, on its diagonal afterwards, and eigenvectors, as columns of E,
   by Jacobi's rotations. E is a rotation. */
static void demi_jacobi3(double M[3][3], double E[3][3]) {
    int i, j, k, sweep;
    for (i = 0; i < 3; i++) for (j = 0; j < 3; j++) E[i][j] = i == j;
    for (sweep = 0; sweep < 30; sweep++) {
        const double off = M[0][1]*M[0][1] + M[0][2]*M[0][2] + M[1][2]*M[1][2];
        const double all = M[0][0]*M[0][0] + M[1][1]*M[1][1] + M[2][2]*M[2][2];
        if (off <= 1e-30*all) return;
        for (i = 0; i < 2; i++)
            for (j = i + 1; j < 3; j++) {
                double t, c, s, theta;
                if (!(fabs(M[i][j]) > 0)) continue;
                theta = (M[j][j] - M[i][i])/(2*M[i][j]);
                t = (theta < 0 ? -1 : 1)/(fabs(theta) + sqrt(theta*theta + 1));
                c = 1/sqrt(t*t + 1);
                s = t*c;
                for (k = 0; k < 3; k++) {
                    const double a = M[k][i], b = M[k][j];
                    M[k][i] = c*a - s*b;
                    M[k][j] = s*a + c*b;
                }
                for (k = 0; k < 3; k++) {
                    const double a = M[i][k], b = M[j][k];
                    M[i][k] = c*a - s*b;
                    M[j][k] = s*a + c*b;
                }
                for (k = 0; k < 3; k++) {
                    const double a = E[k][i], b = E[k][j];
                    E[k][i] = c*a - s*b;
                    E[k][j] = s*a + c*b;
                }
            }
    }
}

/* Parts of a body: the spheres of a cluster, or the one it is. */
typedef struct demi_part {
    int kind;                      /* DEMI_BALL, ... */
    dem_real radius;               /* m, of the bounding sphere: a ball's own */
    dem_vec3 centre;               /* m, from the body's */
    dem_vec3 axes;                 /* m, of all but balls: lengths as its kind has them */
    dem_quat q;                    /* of all but balls */
} demi_part;
/* What a kind of part tells of itself, and how two keep apart; what touches stands in >>kept. */
typedef struct demi_shape_row {
    const char *name;
    dem_real (*support)(dem_vec3 axes, dem_vec3 n);     /* m, how far it reaches along n (unit) */
    dem_real (*thin)(const demi_part *p);               /* m, smallest radius */
    double (*equal)(const demi_part *p);                /* m, radius of the sphere of its volume */
    double (*curve)(const demi_part *p, double h);      /* m, of curvature where its height is h */
    dem_vec3 (*drawn)(const demi_part *p);              /* m, semi-axes of what files show */
    dem_real (*gap)(const demi_part *p, const demi_part *q, dem_vec3 gap, dem_real enough);
} demi_shape_row;
#define DEMI_SHAPE_DECLARE(KIND, NAME, WORD, GAP, TOUCH) \
    static dem_real demi_##NAME##_support(dem_vec3 axes, dem_vec3 n); \
    static dem_real demi_##NAME##_thin(const demi_part *p); \
    static double demi_##NAME##_equal(const demi_part *p); \
    static double demi_##NAME##_curve(const demi_part *p, double h); \
    static dem_vec3 demi_##NAME##_drawn(const demi_part *p); \
    static dem_real GAP(const demi_part *p, const demi_part *q, dem_vec3 gap, dem_real enough);
DEMI_SHAPES(DEMI_SHAPE_DECLARE)
#define DEMI_SHAPE_ROW(KIND, NAME, WORD, GAP, TOUCH) \
    {WORD, demi_##NAME##_support, demi_##NAME##_thin, demi_##NAME##_equal, demi_##NAME##_curve, \
     demi_##NAME##_drawn, GAP},
static const demi_shape_row demi_shape_rows[] = {DEMI_SHAPES(DEMI_SHAPE_ROW)};
static int demi_shape_kind(const demi_shape *shape) { return shape ? shape->kind : DEMI_BALL; }
/* "a sphere", "an ellipsoid". */
static const char *demi_an(const char *name) { return strchr("aeiou", name[0]) ? "n" : ""; }

/* Volume, first and second moments of matter about the origin: 1, x y z, xx yy zz xy xz yz. */
typedef struct demi_moments { double one, x[3], xx[6]; } demi_moments;
/* Adds matter of volume v about c; own: its mean square extent along an axis, about its own
   centre. */
static void demi_moments_add(demi_moments *m, double v, const double *c, double own) {
    int k;
    m->one += v;
    for (k = 0; k < 3; k++) {
        m->x[k] += v*c[k];
        m->xx[k] += v*(c[k]*c[k] + own);
    }
    m->xx[3] += v*c[0]*c[1];
    m->xx[4] += v*c[0]*c[2];
    m->xx[5] += v*c[1]*c[2];
}
/* The union of spheres by rays along x through the middles of rays x rays squares of their outline:
   along a ray the union of intervals is exact. 512 rays: a few 1e-6 for three spheres. room: two
   doubles per sphere. */
static void demi_moments_union(const demi_shape *shape, int rays, double *room, demi_moments *m) {
    double lo[2], hi[2], step[2];
    int i, j, k, e, n;
    lo[0] = lo[1] = 1e300;
    hi[0] = hi[1] = -1e300;
    for (i = 0; i < shape->count; i++)
        for (e = 0; e < 2; e++) {
            const double c = (double)shape->parts[4*i + 1 + e], r = (double)shape->parts[4*i + 3];
            lo[e] = DEMI_MIN(lo[e], c - r);
            hi[e] = DEMI_MAX(hi[e], c + r);
        }
    for (e = 0; e < 2; e++) step[e] = (hi[e] - lo[e])/rays;
    for (j = 0; j < rays; j++)
        for (k = 0; k < rays; k++) {
            double c[3], from, to;
            c[1] = lo[0] + (j + 0.5)*step[0];
            c[2] = lo[1] + (k + 0.5)*step[1];
            for (i = n = 0; i < shape->count; i++) {     /* intervals, sorted as they come */
                const double y = c[1] - (double)shape->parts[4*i + 1];
                const double z = c[2] - (double)shape->parts[4*i + 2];
                const double r = (double)shape->parts[4*i + 3], h = r*r - y*y - z*z;
                if (h <= 0) continue;
                from = (double)shape->parts[4*i] - sqrt(h);
                to = (double)shape->parts[4*i] + sqrt(h);
                for (e = n++; e > 0 && room[2*e - 2] > from; e--) {
                    room[2*e] = room[2*e - 2];
                    room[2*e + 1] = room[2*e - 1];
                }
                room[2*e] = from;
                room[2*e + 1] = to;
            }
            for (i = 0; i < n; i = e) {
                from = room[2*i];
                to = room[2*i + 1];
                for (e = i + 1; e < n && room[2*e] <= to; e++) to = DEMI_MAX(to, room[2*e + 1]);
                c[0] = (from + to)/2;
                demi_moments_add(m, (to - from)*step[0]*step[1], c, 0);
                m->xx[0] += step[0]*step[1]*(to - from)*(to - from)*(to - from)/12;
                m->xx[1] += (to - from)*step[0]*step[1]*step[0]*step[0]/12;
                m->xx[2] += (to - from)*step[0]*step[1]*step[1]*step[1]/12;
            }
        }
}

/* Turns moments into the shape's volume, centre, principal frame and moments per mass. */
static void demi_shape_principal(demi_shape *shape, const demi_moments *m) {
    double M[3][3], E[3][3], c[3], trace, I[6];
    int i, k;
    shape->volume = m->one;
    for (k = 0; k < 3; k++) c[k] = m->x[k]/m->one;
    shape->centre = demi_v((dem_real)c[0], (dem_real)c[1], (dem_real)c[2]);
    for (k = 0; k < 6; k++) I[k] = m->xx[k]/m->one;
    for (k = 0; k < 3; k++) I[k] -= c[k]*c[k];
    I[3] -= c[0]*c[1]; I[4] -= c[0]*c[2]; I[5] -= c[1]*c[2];
    M[0][0] = I[0]; M[1][1] = I[1]; M[2][2] = I[2];
    M[0][1] = M[1][0] = I[3]; M[0][2] = M[2][0] = I[4]; M[1][2] = M[2][1] = I[5];
    trace = I[0] + I[1] + I[2];                 /* spread of matter -> moments of inertia */
    for (i = 0; i < 3; i++)                     /* round-off is no reason to turn the frame */
        for (k = 0; k < 3; k++) if (i != k && fabs(M[i][k]) < 1e-12*trace) M[i][k] = 0;
    demi_jacobi3(M, E);
    shape->inertia = demi_v((dem_real)(trace - M[0][0]), (dem_real)(trace - M[1][1]),
                           (dem_real)(trace - M[2][2]));
    shape->frame = demi_quat_of(E);
}

/* What the search and the time step want to know of a shape: how far it reaches, how far from the
   centre a contact's force may pass, its smallest radius, and how light and blunt it may seem in a
   contact: mass 1/g over (l/h)^2 at worst, g = n.K n of its own half. */
static void demi_cluster_bounds(demi_shape *shape) {
    const dem_vec3 I = shape->inertia;
    const double least = (double)DEMI_MIN(I.x, DEMI_MIN(I.y, I.z));
    int i;
    shape->radius = shape->moment_arm = shape->blunt = 0;
    shape->thin = shape->parts[3];
    for (i = 0; i < shape->count; i++) {
        const dem_real l = demi_length(demi_at(shape->parts + 4*i)), r = shape->parts[4*i + 3];
        shape->radius = DEMI_MAX(shape->radius, l + r);
        shape->moment_arm = DEMI_MAX(shape->moment_arm, l);
        shape->thin = DEMI_MIN(shape->thin, r);
        shape->blunt = DEMI_MAX(shape->blunt, r);
    }
    shape->light = 1/(1 + (double)shape->moment_arm*(double)shape->moment_arm/least);
}
static void demi_ellipsoid_bounds(demi_shape *shape) {
    const double I[3] = {(double)shape->inertia.x, (double)shape->inertia.y,
                         (double)shape->inertia.z};
    const double a[3] = {(double)shape->axes.x, (double)shape->axes.y, (double)shape->axes.z};
    const double l = pow(a[0]*a[1]*a[2], 1.0/3);
    int i, k, j;
    shape->radius = (dem_real)DEMI_MAX(a[0], DEMI_MAX(a[1], a[2]));
    shape->thin = (dem_real)DEMI_MIN(a[0], DEMI_MIN(a[1], a[2]));
    shape->moment_arm = shape->radius - shape->thin;
    shape->blunt = (dem_real)(l*l*l)/(shape->thin*shape->thin);
    shape->light = 1;
    for (k = 0; k < 3; k++)                     /* normals in the three principal planes */
        for (i = 0; i <= 64; i++) {
            const double n0 = cos(DEMI_PI/2*i/64), n1 = sin(DEMI_PI/2*i/64);
            const double u = a[k], v = a[(k + 1)%3], h = sqrt(n0*n0*u*u + n1*n1*v*v);
            const double arm = n0*n1*(u*u - v*v)/h;
            j = (k + 2)%3;
            shape->light = DEMI_MIN(shape->light, h*h/(l*l)/(1 + arm*arm/I[j]));
        }
}

/* Takes over a prepared shape (its array included) or frees it. */
static void demi_shape_free(dem_world *w, demi_shape *shape) {
    demi_free(w, shape->parts);
}
/* Do parts of these two kinds know each other? (>>kept) */
static int demi_meet_known(int kind, int other);
/* 1 with a sentence when a shape that is to be added does not know another, its like or spheres. */
static int demi_shapes_strange(dem_world *w, const char *call, int kind) {
    int i, other;
    for (i = -1; i <= w->shape_count; i++) {
        other = i < 0 ? DEMI_BALL : i < w->shape_count ? w->shapes[i].kind : kind;
        if (demi_meet_known(kind, other)) continue;
        demi_fail(w, DEM_ERROR_ARGUMENT, "%s: shape %d, a%s %s, and shape %d, a%s %s, do not know "
                  "each other: a world holds one or the other; nothing was added", call,
                  w->shape_count + 1, demi_an(demi_shape_rows[kind].name),
                  demi_shape_rows[kind].name, i + 1, demi_an(demi_shape_rows[other].name),
                  demi_shape_rows[other].name);
        return 1;
    }
    return 0;
}
static dem_shape demi_shape_adopt(dem_world *w, const char *call, demi_shape *shape) {
    dem_shape id;
    id.id = 0;
    if (demi_shapes_strange(w, call, shape->kind)) { demi_shape_free(w, shape); return id; }
    if (!demi_grow(w, DEMI_SCENE, &w->shapes, sizeof *w->shapes, (size_t)w->shape_count + 1)) {
        demi_shape_free(w, shape);
        demi_no_memory(w, call);
        return id;
    }
    shape->equal = (dem_real)pow(shape->volume*3/(4*DEMI_PI), 1.0/3);
    w->shapes[w->shape_count++] = *shape;
    demi_built(w, call);
    id.id = w->shape_count;
    return id;
}
/* 1 with a sentence where bodies are discs: shapes are of three dimensions. */
static int demi_shape_planar(dem_world *w, const char *call) {
    if (!w->desc.planar) return 0;
    demi_fail(w, DEM_ERROR_ARGUMENT, "%s: the world is planar, where bodies are discs; set planar "
              "to 0, or use discs", call);
    return 1;
}

DEM_API dem_shape dem_shape_ellipsoid_add(dem_world *w, dem_vec3 a) {
    if (demi_null(w, "dem_shape_ellipsoid_add", w, "world")) return demi_no_shape;
    demi_shape shape;
    dem_shape none;
    const double lo = (double)DEMI_MIN(a.x, DEMI_MIN(a.y, a.z));
    const double hi = (double)DEMI_MAX(a.x, DEMI_MAX(a.y, a.z));
    none.id = 0;
    if (demi_shape_planar(w, "dem_shape_ellipsoid_add")) return none;
    if (!demi_finite3(a) || !(lo > 0) || !(hi <= 1000*lo)) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "dem_shape_ellipsoid_add: semi-axes are %g, %g and %g m, "
                  "must be > 0 and the longest at most 1000 times the shortest; give half "
                  "lengths, in metres", (double)a.x, (double)a.y, (double)a.z);
        return none;
    }
    memset(&shape, 0, sizeof shape);
    shape.kind = DEMI_ELLIPSOID;
    shape.axes = a;
    shape.volume = 4*DEMI_PI/3*(double)a.x*(double)a.y*(double)a.z;
    shape.inertia = demi_v((a.y*a.y + a.z*a.z)/5, (a.x*a.x + a.z*a.z)/5, (a.x*a.x + a.y*a.y)/5);
    shape.frame = dem_quat_make(1, 0, 0, 0);
    demi_ellipsoid_bounds(&shape);
    return demi_shape_adopt(w, "dem_shape_ellipsoid_add", &shape);
}

/* Do no two spheres overlap? Then there is nothing to count twice. */
static int demi_cluster_apart(const demi_shape *shape) {
    int i, j;
    for (i = 0; i < shape->count; i++)
        for (j = i + 1; j < shape->count; j++) {
            const dem_real sum = shape->parts[4*i + 3] + shape->parts[4*j + 3];
            const dem_vec3 d = demi_sub(demi_at(shape->parts + 4*j), demi_at(shape->parts + 4*i));
            if (demi_dot(d, d) < sum*sum*DEM_R(0.999999)) return 0;
        }
    return 1;
}
/* Moments of a cluster, by the way its desc asks for. 0 when memory ran out. ([MIL] gives its
   tetrahedra the inertia of a sphere, and updates spins without the gyroscopic part.) */
static int demi_cluster_moments(dem_world *w, const dem_cluster_desc *desc, const demi_shape *shape,
                                demi_moments *m) {
    int i, k;
    memset(m, 0, sizeof *m);
    if (desc->mass == DEM_CLUSTER_GIVEN) {
        const double v = (double)desc->volume, c[3] = {(double)desc->centre.x,
            (double)desc->centre.y, (double)desc->centre.z};
        const double half = (double)(desc->inertia[0] + desc->inertia[1] + desc->inertia[2])/2;
        demi_moments_add(m, v, c, 0);
        for (k = 0; k < 3; k++) m->xx[k] += half - (double)desc->inertia[k];
        for (k = 3; k < 6; k++) m->xx[k] -= (double)desc->inertia[k];
        return 1;
    }
    if (desc->mass == DEM_CLUSTER_SUM || demi_cluster_apart(shape)) {
        for (i = 0; i < shape->count; i++) {
            const double r = (double)shape->parts[4*i + 3], v = 4*DEMI_PI/3*r*r*r;
            double c[3];
            for (k = 0; k < 3; k++) c[k] = (double)shape->parts[4*i + k];
            demi_moments_add(m, v, c, r*r/5);
        }
        return 1;
    } else {
        const size_t n = 2*(size_t)shape->count;
        double *room = (double *)demi_alloc(w, n, sizeof(double));
        if (!room) return 0;
        demi_moments_union(shape, desc->rays > 0 ? desc->rays : 512, room, m);
        demi_free(w, room);
        return 1;
    }
}
/* 0 with a sentence when the desc is not right. */
static int demi_cluster_check(dem_world *w, const dem_cluster_desc *desc) {
    const char *call = "dem_shape_cluster_add";
    const dem_real *I = desc->inertia;
    int i;
    if (desc->count < 1 || desc->count > 1000 || !desc->positions || desc->rays < 0 ||
        desc->rays > 4096 || (desc->rays > 0 && desc->rays < 16)) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "%s: count is %d and rays %d, must be 1 to 1000 with "
                  "positions (count x 3), and 0 or 16 to 4096", call, desc->count, desc->rays);
        return 0;
    }
    for (i = 0; i < desc->count; i++) {
        const dem_real r = desc->radii ? desc->radii[i] : desc->radius;
        if (demi_finite(r) && r > 0 && demi_finite3(demi_at(desc->positions + 3*i))) continue;
        demi_fail(w, DEM_ERROR_ARGUMENT, "%s: sphere %d has radius %g m at (%g, %g, %g), must be "
                  "> 0 and finite; fill in radii or radius", call, i, (double)r,
                  (double)desc->positions[3*i], (double)desc->positions[3*i + 1],
                  (double)desc->positions[3*i + 2]);
        return 0;
    }
    if ((int)desc->mass < 0 || desc->mass > DEM_CLUSTER_GIVEN) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "%s: mass is %d, must be a DEM_CLUSTER_ value; start from "
                  "DEM_CLUSTER_DESC", call, (int)desc->mass);
        return 0;
    }
    if (desc->mass != DEM_CLUSTER_GIVEN) return 1;
    if (desc->volume > 0 && demi_finite(desc->volume) && demi_finite3(desc->centre) && I[0] > 0 &&
        I[1] > 0 && I[2] > 0 && I[0] <= I[1] + I[2] && I[1] <= I[0] + I[2] && I[2] <= I[0] + I[1] &&
        demi_finite(I[3]) && demi_finite(I[4]) && demi_finite(I[5]) &&
        demi_finite(I[0] + I[1] + I[2])) return 1;
    demi_fail(w, DEM_ERROR_ARGUMENT, "%s: the volume given is %g m3 and the moments %g, %g, %g m5, "
              "must be > 0 and no moment larger than the other two together; per density, not "
              "times it", call, (double)desc->volume, (double)I[0], (double)I[1], (double)I[2]);
    return 0;
}
/* 1 with a sentence when rays lie so far apart that they may miss a sphere. */
static int demi_cluster_coarse(dem_world *w, const dem_cluster_desc *desc, const demi_shape *shape,
                               dem_real least) {
    const int rays = desc->rays > 0 ? desc->rays : 512;
    double side = 0;
    int i, j, e;
    if (desc->mass != DEM_CLUSTER_UNION || demi_cluster_apart(shape)) return 0;
    for (i = 0; i < shape->count; i++)
        for (j = 0; j < shape->count; j++)
            for (e = 1; e < 3; e++) {
                const double to = (double)(shape->parts[4*i + e] + shape->parts[4*i + 3]);
                side = DEMI_MAX(side, to - (double)(shape->parts[4*j + e] - shape->parts[4*j + 3]));
            }
    if (side/rays <= (double)least/4) return 0;
    demi_fail(w, DEM_ERROR_ARGUMENT, "dem_shape_cluster_add: rays is %d, so that rays lie %.3g m "
              "apart, more than a quarter of the smallest radius %g m; set rays to %.0f or more, "
              "at most 4096, or give the moments", rays, side/rays, (double)least,
              ceil(4*side/(double)least));
    return 1;
}
DEM_API dem_shape dem_shape_cluster_add(dem_world *w, const dem_cluster_desc *desc) {
    if (demi_null(w, "dem_shape_cluster_add", desc, "desc")) return demi_no_shape;
    demi_shape shape;
    demi_moments m;
    dem_shape none;
    dem_vec3 about = demi_v(0, 0, 0);
    dem_real least = DEMI_SINGLE ? DEM_R(FLT_MAX) : (dem_real)DBL_MAX;
    int i;
    none.id = 0;
    if (demi_shape_planar(w, "dem_shape_cluster_add") || !demi_cluster_check(w, desc)) return none;
    memset(&shape, 0, sizeof shape);
    shape.kind = DEMI_BALL;
    shape.count = desc->count;
    shape.parts = (dem_real *)demi_hold(w, DEMI_SCENE, 4*(size_t)shape.count, sizeof(dem_real));
    if (!shape.parts) { demi_no_memory(w, "dem_shape_cluster_add"); return none; }
    /* a frame may be far off */
    if (desc->mass != DEM_CLUSTER_GIVEN) about = demi_at(desc->positions);
    for (i = 0; i < shape.count; i++) {
        demi_put(shape.parts + 4*i, demi_sub(demi_at(desc->positions + 3*i), about));
        shape.parts[4*i + 3] = desc->radii ? desc->radii[i] : desc->radius;
        least = DEMI_MIN(least, shape.parts[4*i + 3]);
    }
    if (demi_cluster_coarse(w, desc, &shape, least)) { demi_shape_free(w, &shape); return none; }
    if (!demi_cluster_moments(w, desc, &shape, &m)) {
        demi_shape_free(w, &shape);
        demi_no_memory(w, "dem_shape_cluster_add");
        return none;
    }
    demi_shape_principal(&shape, &m);
    if (!(shape.inertia.x > 0 && shape.inertia.y > 0 && shape.inertia.z > 0)) {
        demi_shape_free(w, &shape);
        demi_fail(w, DEM_ERROR_ARGUMENT, "dem_shape_cluster_add: a principal moment of inertia is "
                  "not > 0; %s", desc->mass == DEM_CLUSTER_GIVEN
                  ? "the off-diagonal parts given are too large" : "use more rays");
        return none;
    }
    for (i = 0; i < shape.count; i++)
        demi_put(shape.parts + 4*i,
                 dem_quat_unrotate(shape.frame, demi_sub(demi_at(shape.parts + 4*i),
                                                                        shape.centre)));
    shape.centre = demi_add(shape.centre, about);
    demi_cluster_bounds(&shape);
    return demi_shape_adopt(w, "dem_shape_cluster_add", &shape);
}

/* Index of a shape, or -1 with a sentence. */
static int demi_shape_index(dem_world *w, const char *call, dem_shape shape) {
    if (shape.id >= 1 && shape.id <= w->shape_count) return shape.id - 1;
    demi_fail(w, DEM_ERROR_ARGUMENT, "%s: shape %d does not exist, there are %d; add it with "
              "dem_shape_ellipsoid_add or dem_shape_cluster_add and check what that returned",
              call, (int)shape.id, w->shape_count);
    return -1;
}
DEM_API dem_result dem_shape_get(const dem_world *world, dem_shape shape, dem_shape_info *info) {
    if (demi_null(world, "dem_shape_get", info, "info")) return DEM_ERROR_ARGUMENT;
    const int i = demi_shape_index((dem_world *)world, "dem_shape_get", shape);
    const demi_shape *s;
    dem_vec3 I;
    if (i < 0) return DEM_ERROR_ARGUMENT;
    s = &world->shapes[i];
    I = s->inertia;
    info->spheres = s->count;
    info->volume = (dem_real)s->volume;
    info->centre = s->centre;
    info->frame = s->frame;
    info->inertia = demi_scale(I, (dem_real)s->volume);
    info->semi_axes = s->axes;
    if (s->kind != DEMI_ELLIPSOID)
        info->semi_axes = demi_v(DEMI_SQRT(DEM_R(2.5)*DEMI_MAX(I.y + I.z - I.x, 0)),
                                 DEMI_SQRT(DEM_R(2.5)*DEMI_MAX(I.x + I.z - I.y, 0)),
                                 DEMI_SQRT(DEM_R(2.5)*DEMI_MAX(I.x + I.y - I.z, 0)));
    info->radius = s->radius;
    return DEM_OK;
}

/* --- a body and its shape --- */

DEM_INLINE const demi_shape *demi_shape_of(const dem_world *w, int body) {  /* null: a sphere */
    return w->bodies.shape && w->bodies.shape[body] ? &w->shapes[w->bodies.shape[body] - 1] : 0;
}
DEM_INLINE dem_real demi_scale_of(const dem_world *w, int body, const demi_shape *shape) {
    return w->bodies.pos[4*body + 3]/shape->radius;
}
/* Of a shape: per mass and scale, once and for all; of a sphere or disc: the textbook's. */
static dem_vec3 demi_moments_of(const dem_world *w, int body) {        /* kg m2, principal */
    const demi_shape *shape = demi_shape_of(w, body);
    const double m = (double)w->bodies.mass[body], r = (double)w->bodies.pos[4*body + 3];
    dem_real one;
    if (shape) {
        one = demi_scale_of(w, body, shape);
        return demi_scale(shape->inertia, (dem_real)m*one*one);
    }
    one = (dem_real)(w->desc.planar ? m*r*r/2 : 0.4*m*r*r);
    return demi_v(one, one, one);
}
/* Angular momentum of a body, of its spin at the full step; kg m2/s. */
static dem_vec3 demi_angular_of(const dem_world *w, int body) {
    const dem_vec3 I = demi_moments_of(w, body), spin = demi_at(w->bodies.spin + 4*body);
    dem_quat q;
    dem_vec3 own;
    if (!demi_shape_of(w, body)) return demi_scale(spin, I.x);
    q = demi_quat_at(w->bodies.orient + 4*body);
    own = dem_quat_unrotate(q, spin);
    return dem_quat_rotate(q, demi_v(I.x*own.x, I.y*own.y, I.z*own.z));
}
/* How far a body reaches from its centre in direction n (unit), m. */
static dem_real demi_support(const dem_world *w, int body, dem_vec3 n) {
    const demi_shape *shape = demi_shape_of(w, body);
    dem_real scale, far = -1;
    dem_vec3 e;
    int i;
    if (!shape) return w->bodies.pos[4*body + 3];
    scale = demi_scale_of(w, body, shape);
    e = dem_quat_unrotate(demi_quat_at(w->bodies.orient + 4*body), n);
    if (!shape->count) return scale*demi_shape_rows[shape->kind].support(shape->axes, e);
    for (i = 0; i < shape->count; i++) {
        const dem_real s = demi_dot(demi_at(shape->parts + 4*i), e) + shape->parts[4*i + 3];
        far = i && far > s ? far : s;
    }
    return scale*far;
}

/* --- where two ellipsoids meet. Perram and Wertheim's function [PW85] of two ellipsoids
         (x - xA).QA^-1 (x - xA) <= 1, Q = R diag(a^2, b^2, c^2) R^T, r = xB - xA, 0 < l < 1:
             K = (1 - l) QA + l QB,  s = K^-1 r,  f(l) = l (1 - l) r.s
       has one maximum, W0^2: scaled by W0 the two touch in xA + (1 - l) QA s, with the normal
       s/|s|. There fA = (1 - l)^2 s.QA s and fB = l^2 s.QB s are equal. We solve ln(fA/fB)/2 = 0 by
       Newton's method, with slope -C ((1 - l)/fA + l/fB), C = s.QA K^-1 QB s, kept in a bracket.
       Any f(l) > 1 shows that the two are apart. No inverse of Q appears: needles and discs are
       safe. Shrinking both by W until they part [RUB15] 3.2 ends at this point and normal exactly,
       and its line V2 V3 has the direction QA K^-1 QB s. Checked by the sentence on "quartic and
       eigenvectors". --- */
typedef struct demi_meet {
    double l, f, fa, fb;           /* lambda; the function; scaled distances squared */
    double s[3], a[3], b[3];       /* s, QA s, QB s */
    double v[3];                   /* K^-1 QB s */
    int iterations;
} demi_meet;

static void demi_sym_times(const double *Q, const double *x, double *out) {  /* xx yy zz xy xz yz */
    out[0] = Q[0]*x[0] + Q[3]*x[1] + Q[4]*x[2];
    out[1] = Q[3]*x[0] + Q[1]*x[1] + Q[5]*x[2];
    out[2] = Q[4]*x[0] + Q[5]*x[1] + Q[2]*x[2];
}
static double demi_dot3(const double *a, const double *b) {
    return a[0]*b[0] + a[1]*b[1] + a[2]*b[2];
}
/* Q of an ellipsoid. */
static void demi_ellipsoid_matrix(dem_quat q, dem_vec3 axes, double *Q) {
    const double w = (double)q.w, x = (double)q.x, y = (double)q.y, z = (double)q.z;
    const double A = (double)axes.x*(double)axes.x, B = (double)axes.y*(double)axes.y;
    const double C = (double)axes.z*(double)axes.z;
    const double R[9] = {1 - 2*(y*y + z*z), 2*(x*y - w*z), 2*(x*z + w*y),
                         2*(x*y + w*z), 1 - 2*(x*x + z*z), 2*(y*z - w*x),
                         2*(x*z - w*y), 2*(y*z + w*x), 1 - 2*(x*x + y*y)};
    Q[0] = A*R[0]*R[0] + B*R[1]*R[1] + C*R[2]*R[2];
    Q[1] = A*R[3]*R[3] + B*R[4]*R[4] + C*R[5]*R[5];
    Q[2] = A*R[6]*R[6] + B*R[7]*R[7] + C*R[8]*R[8];
    Q[3] = A*R[0]*R[3] + B*R[1]*R[4] + C*R[2]*R[5];
    Q[4] = A*R[0]*R[6] + B*R[1]*R[7] + C*R[2]*R[8];
    Q[5] = A*R[3]*R[6] + B*R[4]*R[7] + C*R[5]*R[8];
}
static void demi_ball_matrix(dem_real r, double *Q) {
    Q[0] = Q[1] = Q[2] = (double)r*(double)r;
    Q[3] = Q[4] = Q[5] = 0;
}
/* Where to begin: exact for spheres and for ellipsoids that are alike and parallel. */
static double demi_meet_start(const double *A, const double *B, const double *r) {
    double t[3], ha, hb;
    demi_sym_times(A, r, t);
    ha = sqrt(demi_dot3(r, t));
    demi_sym_times(B, r, t);
    hb = sqrt(demi_dot3(r, t));
    return ha + hb > 0 ? ha/(ha + hb) : 0.5;
}
/* The last step is so small that s may follow it along ds/dl = K^-1 (QA - QB) s = (s - v)/(1 - l),
   v = K^-1 QB s, and f to second order, f' = fA - fB, f'' = -2 C: what a whole evaluation more
   would add is of the order of the step squared. */
static void demi_meet_finish(const double *A, double C, double step, demi_meet *m) {
    const double rate = step/(1 - m->l);
    int k;
    m->f += ((m->fa - m->fb) - C*step)*step;
    for (k = 0; k < 3; k++) m->s[k] += rate*(m->s[k] - m->v[k]);
    m->l += step;
    m->fa = m->fb = m->f;
    demi_sym_times(A, m->s, m->a);
}
/* Finds the maximum from m->l on, until fA and fB are as near as `near` says; stops early where
   f(l) exceeds `enough`. DEMI_MEET_NEAR: normals to 1e-10 (aspect ratio 2) to 4e-6 at worst (100),
   and as cheap as it gets; docs/shapes.md has the numbers. */
#define DEMI_MEET_NEAR 1e-4
/* Newton's method on ln(fa/fb), kept between lo and hi: where both are alike, the ellipsoids,
   scaled by their root, touch at one point. Ends early with f > enough: then they are apart,
   whatever the rest would say. */
static void demi_meet_solve(const double *A, const double *B, const double *r, double enough,
                            double near, demi_meet *m) {
    double lo = 0, hi = 1, l = m->l;
    int k;
    for (m->iterations = 1;; m->iterations++) {
        double K[6], J[6], t, C, u, sum, step;
        for (k = 0; k < 6; k++) K[k] = (1 - l)*A[k] + l*B[k];
        J[0] = K[1]*K[2] - K[5]*K[5]; J[3] = K[4]*K[5] - K[3]*K[2]; J[4] = K[3]*K[5] - K[1]*K[4];
        J[1] = K[0]*K[2] - K[4]*K[4]; J[5] = K[3]*K[4] - K[0]*K[5]; J[2] = K[0]*K[1] - K[3]*K[3];
        t = 1/(K[0]*J[0] + K[3]*J[3] + K[4]*J[4]);
        for (k = 0; k < 6; k++) J[k] *= t;      /* K^-1, by cofactors: one quotient */
        demi_sym_times(J, r, m->s);
        m->l = l;
        m->f = l*(1 - l)*demi_dot3(r, m->s);
        demi_sym_times(A, m->s, m->a);
        demi_sym_times(B, m->s, m->b);
        m->fa = (1 - l)*(1 - l)*demi_dot3(m->s, m->a);
        m->fb = l*l*demi_dot3(m->s, m->b);
        if (m->f > enough) return;
        demi_sym_times(J, m->b, m->v);
        sum = m->fa + m->fb;
        if (!(sum > 0)) return;
        u = (m->fa - m->fb)/sum;
        if (u > 0) lo = l; else hi = l;
        /* ln(fa/fb)/2 = atanh u, which is about u (15 - 4 u^2)/(15 - 9 u^2) */
        C = demi_dot3(m->a, m->v);
        step = u*(15 - 4*u*u)*m->fa*m->fb/
            ((15 - 9*u*u)*C*((1 - l)*m->fb + l*m->fa));
        if (fabs(u) < near || m->iterations >= 100 || hi - lo < 1e-15) {
            demi_meet_finish(A, C, step, m);
            return;
        }
        l += step;
        if (!(l > lo && l < hi)) l = (lo + hi)/2;
    }
}
/* Heights along the normal, and its length undone. */
static void demi_meet_heights(const demi_meet *m, double *n, double *ha, double *hb) {
    const double l = sqrt(demi_dot3(m->s, m->s));
    int k;
    for (k = 0; k < 3; k++) n[k] = m->s[k]/l;
    *ha = sqrt(m->fa)/((1 - m->l)*l);
    *hb = sqrt(m->fb)/(m->l*l);
}
/* [RUB15] 3.2: the piece of the line through the contact along V2 V3 that lies in both: it leaves A
   at the larger root of (x + t d).QA^-1 (x + t d) = 1 and enters B at the smaller one of B's. */
static double demi_meet_chord(const demi_meet *m, const double *A) {
    double d[3], u[3], ds, dv, du, out, in;
    int k;
    if (!(m->f < 1)) return 0;
    demi_sym_times(A, m->v, d);
    for (k = 0; k < 3; k++) u[k] = (m->s[k] - m->l*m->v[k])/(1 - m->l);
    ds = demi_dot3(d, m->s);
    dv = demi_dot3(d, m->v);
    du = demi_dot3(d, u);
    out = (-(1 - m->l)*ds + sqrt((1 - m->l)*(1 - m->l)*ds*ds + dv*(1 - m->fa)))/dv;
    in = (m->l*ds - sqrt(m->l*m->l*ds*ds + du*(1 - m->fb)))/du;
    return (out - in)*sqrt(demi_dot3(d, d));
}
DEM_API dem_ellipsoid_contact dem_ellipsoids_contact(const dem_ellipsoid *a, const dem_ellipsoid *b,
                                        dem_real lambda) {
    if (!a || !b) { dem_ellipsoid_contact nothing; memset(&nothing, 0,
                                                          sizeof nothing); return nothing; }
    const dem_quat none = dem_quat_make(1, 0, 0, 0);
    const dem_quat qa = demi_quat_most(a->orientation) > 0 ? demi_quat_unit(a->orientation) : none;
    const dem_quat qb = demi_quat_most(b->orientation) > 0 ? demi_quat_unit(b->orientation) : none;
    const dem_vec3 gap = demi_sub(b->position, a->position);
    double A[6], B[6], r[3], n[3], ha, hb, w0;
    dem_ellipsoid_contact out;
    demi_meet m;
    r[0] = (double)gap.x; r[1] = (double)gap.y; r[2] = (double)gap.z;
    memset(&out, 0, sizeof out);
    demi_ellipsoid_matrix(qa, a->semi_axes, A);
    demi_ellipsoid_matrix(qb, b->semi_axes, B);
    if (!(demi_dot3(r, r) > 0)) {               /* centres coincide: any direction is as good */
        r[2] = 1e-12*((double)a->semi_axes.z + (double)b->semi_axes.z);
    }
    m.l = lambda > 0 && lambda < 1 ? (double)lambda : demi_meet_start(A, B, r);
    demi_meet_solve(A, B, r, 1e300, 1e-12, &m);
    demi_meet_heights(&m, n, &ha, &hb);
    w0 = sqrt(m.f);
    out.scale = (dem_real)w0;
    out.lambda = (dem_real)m.l;
    out.iterations = m.iterations;
    out.normal = demi_v((dem_real)n[0], (dem_real)n[1], (dem_real)n[2]);
    out.point = demi_add(a->position, demi_v((dem_real)((1 - m.l)*m.a[0]),
        (dem_real)((1 - m.l)*m.a[1]), (dem_real)((1 - m.l)*m.a[2])));
    out.depth_normal = (dem_real)((1 - w0)*(ha + hb));
    out.depth_chord = (dem_real)demi_meet_chord(&m, A);
    out.depth_conservative = (dem_real)((1 - w0)*
        (pow((double)a->semi_axes.x*(double)a->semi_axes.y*(double)a->semi_axes.z, 1.0/3) +
         pow((double)b->semi_axes.x*(double)b->semi_axes.y*(double)b->semi_axes.z, 1.0/3)));
    return out;
}

/* --- parts of bodies, and how far apart they are --- */

static int demi_parts_count(const dem_world *w, int body) {
    const demi_shape *shape = demi_shape_of(w, body);
    return shape && shape->count ? shape->count : 1;
}
/* Part k as the body is turned now, worked out from its quaternion. */
static demi_part demi_part_of(const dem_world *w, int body, int k) {
    const demi_shape *shape = demi_shape_of(w, body);
    demi_part p;
    memset(&p, 0, sizeof p);
    p.kind = demi_shape_kind(shape);
    p.radius = w->bodies.pos[4*body + 3];
    if (shape) {
        const dem_real scale = demi_scale_of(w, body, shape);
        p.q = demi_quat_at(w->bodies.orient + 4*body);
        if (shape->count) {
            p.centre = demi_scale(dem_quat_rotate(p.q, demi_at(shape->parts + 4*k)), scale);
            p.radius = shape->parts[4*k + 3]*scale;
        } else p.axes = demi_scale(shape->axes, scale);
    }
    return p;
}
/* The spheres of a cluster, as they are turned now: rows of centre and radius. */
static const dem_real *demi_centres_of(const dem_world *w, int body) {
    return w->bodies.centre + 4*w->bodies.centre_start[body];
}
/* Spheres of one cluster after it has turned: once a step, not once a contact. */
static void demi_centres_rotate(dem_world *w, int body) {
    const demi_shape *shape = demi_shape_of(w, body);
    const dem_quat q = demi_quat_at(w->bodies.orient + 4*body);
    const dem_real scale = demi_scale_of(w, body, shape);
    dem_real *sphere = w->bodies.centre + 4*w->bodies.centre_start[body];
    int k;
    for (k = 0; k < shape->count; k++, sphere += 4) {
        demi_put(sphere, demi_scale(dem_quat_rotate(q, demi_at(shape->parts + 4*k)), scale));
        sphere[3] = shape->parts[4*k + 3]*scale;
    }
}
/* Lays all of them. 0 when memory ran out. */
static int demi_centres_lay(dem_world *w) {
    int32_t *start;
    int i, n = 0;
    if (!DEMI_GROW(w, w->bodies.centre_start, (size_t)w->bodies.count + 1)) return 0;
    start = w->bodies.centre_start;
    for (i = 0; i < w->bodies.count; i++) {
        const demi_shape *shape = demi_shape_of(w, i);
        start[i] = n;
        if (shape && n > INT_MAX/8 - shape->count) return 0;
        n += shape ? shape->count : 0;
    }
    if (!DEMI_GROW(w, w->bodies.centre, 4*((size_t)n + 1))) return 0;
    w->bodies.centres_valid = 1;
    for (i = 0; i < w->bodies.count; i++)
        if (demi_shape_of(w, i) && demi_shape_of(w, i)->count) demi_centres_rotate(w, i);
    return 1;
}
static void demi_part_matrix(const demi_part *p, double *Q) {
    if (p->kind == DEMI_BALL) demi_ball_matrix(p->radius, Q);
    else demi_ellipsoid_matrix(p->q, p->axes, Q);
}
/* --- what a kind of part tells of itself (DEMI_SHAPES) --- */

static dem_real demi_ball_support(dem_vec3 axes, dem_vec3 n) { (void)n; return axes.x; }
static dem_real demi_ball_thin(const demi_part *p) { return p->radius; }
static double demi_ball_equal(const demi_part *p) { return (double)p->radius; }
static double demi_ball_curve(const demi_part *p, double h) { (void)h; return (double)p->radius; }
static dem_vec3 demi_ball_drawn(const demi_part *p) {
    return demi_v(p->radius, p->radius, p->radius);
}
static dem_real demi_ellipsoid_support(dem_vec3 axes, dem_vec3 n) {
    return demi_length(demi_v(n.x*axes.x, n.y*axes.y, n.z*axes.z));
}
static dem_real demi_ellipsoid_thin(const demi_part *p) {
    return DEMI_MIN(p->axes.x, DEMI_MIN(p->axes.y, p->axes.z));
}
static double demi_ellipsoid_equal(const demi_part *p) {
    return pow((double)p->axes.x*(double)p->axes.y*(double)p->axes.z, 1.0/3);
}
/* Gauss's: a b c/h^2. */
static double demi_ellipsoid_curve(const demi_part *p, double h) {
    return (double)p->axes.x*(double)p->axes.y*(double)p->axes.z/(h*h);
}
static dem_vec3 demi_ellipsoid_drawn(const demi_part *p) { return p->axes; }
/* By the table of kinds. */
static dem_real demi_part_thin(const demi_part *p) { return demi_shape_rows[p->kind].thin(p); }
static double demi_part_equal(const demi_part *p) { return demi_shape_rows[p->kind].equal(p); }
/* The radius that a contact's stiffness is worked out with. A stiffness that changes as the two
   roll would make or lose energy (Hertz: 1 % a collision at aspect ratio 3): where energy is to be
   conserved it is that of equal volume. */
static double demi_part_round(const dem_world *w, const demi_part *p, double h) {
    return w->desc.ellipsoid_overlap == DEM_OVERLAP_CONSERVATIVE ? demi_part_equal(p)
        : demi_shape_rows[p->kind].curve(p, h);
}

/* Part k of a body as demi_part_of has it, from the centres that are turned already. */
DEM_INLINE demi_part demi_part_now(const dem_world *w, int body, int k) {
    const demi_shape *shape = demi_shape_of(w, body);
    demi_part p;
    const dem_real *sphere;
    if (shape && !shape->count) return demi_part_of(w, body, k);
    sphere = shape ? demi_centres_of(w, body) + 4*k : w->bodies.pos + 4*body;
    p.kind = DEMI_BALL;
    p.centre = shape ? demi_at(sphere) : demi_v(0, 0, 0);
    p.radius = sphere[3];
    p.axes = demi_v(0, 0, 0);
    p.q = dem_quat_make(1, 0, 0, 0);
    return p;
}
static dem_real demi_balls_gap(const demi_part *p, const demi_part *q, dem_vec3 gap,
                               dem_real enough) {
    (void)enough;
    return demi_length(gap) - p->radius - q->radius;
}
/* Two ellipsoids, or one and a sphere. */
static dem_real demi_ellipsoids_gap(const demi_part *p, const demi_part *q, dem_vec3 gap,
                                    dem_real enough) {
    double A[6], B[6], r[3], n[3], ha, hb;
    demi_meet m;
    r[0] = (double)gap.x; r[1] = (double)gap.y; r[2] = (double)gap.z;
    if (!(demi_length(gap) > 0)) return -enough;
    demi_part_matrix(p, A);
    demi_part_matrix(q, B);
    m.l = demi_meet_start(A, B, r);
    demi_meet_solve(A, B, r, 1e300, DEMI_MEET_NEAR, &m);
    demi_meet_heights(&m, n, &ha, &hb);
    return (dem_real)((sqrt(m.f) - 1)*(ha + hb));
}
/* A lower bound of the distance between two parts, gap = from centre to centre; -`enough` where the
   centres coincide. */
static dem_real demi_parts_gap(const demi_part *p, const demi_part *q, dem_vec3 gap,
                               dem_real enough) {
    return demi_shape_rows[DEMI_MAX(p->kind, q->kind)].gap(p, q, gap, enough);
}
/* The same for two bodies; shift leads from b to the image of it that is nearest to a. */
static dem_real demi_bodies_gap(const dem_world *w, int a, int b, const dem_real *shift,
                                dem_real enough) {
    const dem_vec3 r = demi_add(demi_sub(demi_at(w->bodies.pos + 4*b),
                                         demi_at(w->bodies.pos + 4*a)), demi_at(shift));
    const dem_real d = demi_length(r), rb = w->bodies.pos[4*b + 3];
    const int na = demi_parts_count(w, a), nb = demi_parts_count(w, b);
    dem_real least = enough;
    int i, j;
    if (d > 0) {
        const dem_vec3 n = demi_scale(r, 1/d);
        const dem_real first = d - demi_support(w, a, n) - demi_support(w, b, demi_scale(n, -1));
        if (first >= enough) return first;
    }
    for (i = 0; i < na; i++) {
        const demi_part p = demi_part_now(w, a, i);
        const dem_vec3 to = demi_sub(r, p.centre);
        if (na > 1 && demi_length(to) - p.radius - rb >= least) continue;
        for (j = 0; j < nb; j++) {
            const demi_part q = demi_part_now(w, b, j);
            least = DEMI_MIN(least, demi_parts_gap(&p, &q, demi_add(to, q.centre), least));
        }
    }
    return least;
}

/* ---------------------------------------------------------------------------------------------
   >>bodies
   Grains: who they are (slots, which never move), where they stand in the arrays (indices, which
   change whenever the list is rebuilt), adding, removing, placing. Whoever changes who is where
   calls demi_list_drop first (it stands here because everyone needs it): contact memory is then
   filed by slot and finds its way into the next list.
   --------------------------------------------------------------------------------------------- */

/* --- one notion of place. On a periodic axis a coordinate stands for all its images, a period
       apart. Between two rebuilds bodies may stand up to half a skin outside the box (pairs note
       which image of a partner is nearest, so nobody is moved while a list is in use). Whoever
       asks where a body is, or how far from another, asks here: searches, fills, feeds, outlets,
       fields, getters, writers. Tests: tests/test_periodic.c. --- */
/* lo: m, where the box begins; period: m, 0 where an axis is not periodic, and half then huge. */
typedef struct demi_periods { dem_real lo[3], half[3], period[3]; int any; } demi_periods;
/* The same numbers for every axis, periodic or not, so that loops need not ask: an axis that is not
   has a period of 0, and half of it is out of reach. */
static demi_periods demi_periods_of(const dem_world *w) {
    const dem_vec3 lo = w->desc.domain.lo, size = demi_sub(w->desc.domain.hi, lo);
    demi_periods p;
    int k;
    demi_put(p.lo, lo);
    demi_put(p.period, size);
    for (k = 0, p.any = 0; k < 3; k++) {
        const int periodic = w->desc.boundary[k] == DEM_BOUNDARY_PERIODIC;
        p.any |= periodic;
        p.half[k] = periodic ? p.period[k]/2 : (DEMI_SINGLE ? DEM_R(FLT_MAX) : (dem_real)DBL_MAX);
        if (!periodic) p.period[k] = 0;
    }
    return p;
}
/* Shortest image of a distance d in a period: valid for |d| < 1.5 period. half = huge: not
   periodic. For the innermost loops; elsewhere demi_nearest. */
DEM_INLINE dem_real demi_image(dem_real d, dem_real half, dem_real period) {
    const dem_real up = d < -half ? period : 0, down = d > half ? period : 0;
    return d + up - down;
}
/* The image of coordinate x with from <= image < from + period, whatever rounding does; x itself
   where the period is 0. */
DEM_INLINE dem_real demi_into(dem_real x, dem_real from, dem_real period) {
    if (!(period > 0) || (x >= from && x < from + period)) return x;
    if (x < from) x += period*(dem_real)ceil((double)((from - x)/period));
    else x -= period*(dem_real)floor((double)((x - from)/period));
    if (x >= from + period) x -= period;
    return x < from ? from : x;
}
/* A place in the periodic box. */
static dem_vec3 demi_place_of(const demi_periods *p, dem_vec3 x) {
    if (!p->any) return x;
    return demi_v(demi_into(x.x, p->lo[0], p->period[0]), demi_into(x.y, p->lo[1], p->period[1]),
                  demi_into(x.z, p->lo[2], p->period[2]));
}
/* What is left of a distance between two places, of any size, when the nearest images are taken. */
static dem_vec3 demi_nearest(const demi_periods *p, dem_vec3 d) {
    if (!p->any) return d;
    return demi_v(demi_into(d.x, -p->half[0], p->period[0]),
                  demi_into(d.y, -p->half[1], p->period[1]),
                  demi_into(d.z, -p->half[2], p->period[2]));
}
/* All bodies in the periodic box: count x 4, as bodies.pos. Holds until bodies move or are
   sorted. */
static const dem_real *demi_wrapped(const dem_world *w) {
    const demi_periods p = demi_periods_of(w);
    int i, k;
    if (!p.any) return w->bodies.pos;
    for (i = 0; i < w->bodies.count; i++) {
        for (k = 0; k < 3; k++)
            w->bodies.scratch[4*i + k] = demi_into(w->bodies.pos[4*i + k], p.lo[k], p.period[k]);
        w->bodies.scratch[4*i + 3] = w->bodies.pos[4*i + 3];
    }
    return w->bodies.scratch;
}
static void demi_domain_limits(const dem_world *w, double *lo, double *hi) {
    lo[0] = (double)w->desc.domain.lo.x; lo[1] = (double)w->desc.domain.lo.y;
    lo[2] = (double)w->desc.domain.lo.z;
    hi[0] = (double)w->desc.domain.hi.x; hi[1] = (double)w->desc.domain.hi.y;
    hi[2] = (double)w->desc.domain.hi.z;
}
/* Brings positions back into the periodic box: at a rebuild, when nobody holds images. */
static void demi_wrap(dem_world *w) {
    const demi_periods p = demi_periods_of(w);
    int i, k;
    for (k = 0; k < 3 && p.any; k++) {
        for (i = 0; i < w->bodies.count && p.period[k] > 0; i++) {
            const dem_real from = w->bodies.pos[4*i + k];
            const dem_real to = demi_into(from, p.lo[k], p.period[k]);
            if (w->bodies.backward) w->bodies.last_pos[4*i + k] += to - from;
            w->bodies.pos[4*i + k] = to;
        }
    }
}

/* Is this body a copy of one that another slab owns? (>>slabs; never elsewhere) */
DEM_INLINE int demi_is_ghost(const dem_world *w, int i) {
    return w->bodies.ghost && w->bodies.ghost[w->bodies.slot[i]] == 1;
}

/* Room for filed memory. 0 when memory ran out. */
static int demi_carry_reserve(dem_world *w, int rows, int count, int stride) {
    const size_t reals = (size_t)count*(size_t)stride;
    const int ok = DEMI_GROW(w, w->filed.start, (size_t)rows + 2) &&
                   DEMI_GROW(w, w->filed.partner, (size_t)count) &&
                   DEMI_GROW(w, w->filed.memory, reals);
    return ok;
}

/* Does a near pair remember anything? */
static int demi_near_remembers(const dem_world *w, int d, int p) {
    const dem_real *m = w->near.memory + (size_t)d*(size_t)w->memory_stride*(size_t)w->near.stride;
    int e;
    for (e = 0; e < w->memory_stride; e++) {
        const dem_real value = m[(size_t)e*(size_t)w->near.stride + (size_t)p];
        if (value < 0 || value > 0) return 1;
    }
    return 0;
}
/* The pairs of domain d in the near list are p = 0 .. near_own - 1, then near_cross .. near_end -
   1: the one after p. */
DEM_INLINE int demi_near_next(const demi_domain *domain, int p) {
    return p + 1 == domain->near_own ? domain->near_cross : p + 1;
}
DEM_INLINE int demi_near_first(const demi_domain *domain) {
    return domain->near_own ? 0 : domain->near_cross;
}

/* Files the memory of all touching pairs by slot: row = lower slot; partner = higher slot, or its
   complement when body a of the pair was the higher one. 0 when memory ran out. */
static int demi_carry_collect(dem_world *w) {
    const int stride = w->memory_stride;
    int d, p, e, k, total = 0, pass;
    w->filed.count = 0;
    if (!stride || !w->domain_count) return 1;
    if (!demi_carry_reserve(w, w->bodies.slot_count, 0, stride)) return 0;
    memset(w->filed.start, 0, ((size_t)w->bodies.slot_count + 2)*sizeof(int32_t));
    for (pass = 0; pass < 2; pass++) {          /* count by row, then fill */
        for (d = 0; d < w->domain_count; d++) {
            const demi_domain *domain = &w->domains[d];
            const dem_real *m = w->near.memory + (size_t)d*(size_t)stride*(size_t)w->near.stride;
            for (p = demi_near_first(domain); p < domain->near_end; p = demi_near_next(domain, p)) {
                const int at = d*w->near.stride + p;
                int32_t a, b, row;
                dem_real *to;
                if (!demi_near_remembers(w, d, p)) continue;
                a = (int32_t)w->bodies.slot[w->near.a[at]];
                b = (int32_t)w->bodies.slot[w->near.b[at]];
                row = DEMI_MIN(a, b);
                if (pass == 0) { w->filed.start[row + 2]++; total++; continue; }
                w->filed.partner[w->filed.start[row + 1]] = a < b ? b : ~a;
                to = w->filed.memory + (size_t)w->filed.start[row + 1]++*(size_t)stride;
                for (e = 0; e < stride; e++)
                    to[e] = m[(size_t)e*(size_t)w->near.stride + (size_t)p];
            }
        }
        if (pass == 0) {
            if (!demi_carry_reserve(w, w->bodies.slot_count, total, stride)) return 0;
            for (k = 2; k < w->bodies.slot_count +
                 2; k++) w->filed.start[k] += w->filed.start[k - 1];
        }
    }
    w->filed.count = total;
    w->filed.rows = w->bodies.slot_count;
    w->filed.stride = stride;
    return 1;
}

/* Contacts that domain d keeps. */
DEM_INLINE demi_kept *demi_kept_of(const dem_world *w, int d) {
    return w->kept_now + w->kept_first[d];
}
/* The candidate list no longer fits: save what it remembers. 0 when memory ran out; nothing changed
   then. */
static int demi_list_drop(dem_world *w) {
    int d, k;
    w->bodies.centres_valid = 0;
    if (!w->stage.list_valid) return 1;
    if (!demi_carry_collect(w)) return 0;
    for (d = 0; d < w->domain_count; d++)
        for (k = 0; k < w->domains[d].kept; k++) {
            demi_kept *c = demi_kept_of(w, d) + k;
            c->a = (int32_t)w->bodies.slot[c->a];            /* from here on slots */
            if (c->b >= 0) c->b = (int32_t)w->bodies.slot[c->b];
        }
    w->stage.list_valid = 0;
    return 1;
}

/* --- the arrays of bodies (demi_body_arrays) --- */

/* Does each body of this world (or slot) have one? */
static int demi_has(const dem_world *w, const demi_body_array *a) {
    return a->who == DEMI_BACK ? w->bodies.backward : a->who == DEMI_TURNED ? w->bodies.orienting
           : 1;
}
/* Is it state that each body of this world keeps? */
static int demi_keeps(const dem_world *w, const demi_body_array *a) {
    return a->what && a->who != DEMI_SLOTS && demi_has(w, a);
}
/* Bytes that one body keeps in all. */
static size_t demi_body_size(const dem_world *w) {
    size_t size = 0;
    int k;
    for (k = 0; k < DEMI_BODY_ARRAYS; k++)
        if (demi_keeps(w, &demi_body_arrays[k])) size += demi_body_arrays[k].item;
    return size;
}
static char *demi_data(const dem_world *w, const demi_body_array *a) {
    char *data;
    memcpy(&data, (const char *)&w->bodies + a->field, sizeof data);
    return data;
}
/* What body i has of it. */
static char *demi_datum(const dem_world *w, const demi_body_array *a, int i) {
    return demi_data(w, a) + (size_t)i*a->item;
}
/* New room for those arrays that `chosen` names, a bit for each who, keeping the first `used`
   items. 0 when memory ran out: all are as they were. */
static int demi_bodies_room(dem_world *w, int chosen, size_t used, size_t room) {
    void *fresh[DEMI_BODY_ARRAYS];
    int k;
    for (k = 0; k < DEMI_BODY_ARRAYS; k++) {
        const demi_body_array *a = &demi_body_arrays[k];
        fresh[k] = 0;
        if (!(chosen >> a->who & 1) || !room) continue;
        fresh[k] = demi_hold(w, DEMI_RUN, room, a->item);
        if (fresh[k]) continue;
        while (k--) demi_free(w, fresh[k]);
        return 0;
    }
    for (k = 0; k < DEMI_BODY_ARRAYS; k++) {
        const demi_body_array *a = &demi_body_arrays[k];
        if (!fresh[k]) continue;
        if (used) memcpy(fresh[k], demi_data(w, a), used*a->item);
        demi_free(w, demi_data(w, a));
        memcpy((char *)&w->bodies + a->field, &fresh[k], sizeof fresh[k]);
    }
    return 1;
}
/* Room for so many bodies in all, and for the slots that those to come may need. 0 when memory ran
   out; arrays that have grown already stay so. */
static int demi_bodies_reserve(dem_world *w, size_t count) {
    const size_t old = (size_t)w->bodies.capacity, room = DEMI_MAX(count, old + old/4 + 16);
    /* slots of removed bodies rest until the next list: each body to come may need a new one */
    const size_t more = count > (size_t)w->bodies.count ? count - (size_t)w->bodies.count : 0;
    const size_t slots = (size_t)w->bodies.slot_count + more;
    const int sets =
        1 << DEMI_EVERY | w->bodies.backward << DEMI_BACK | w->bodies.orienting << DEMI_TURNED;
    if (count > (size_t)(INT_MAX/64) || slots > (size_t)(INT_MAX/64)) return 0;
    if (count > (size_t)w->bodies.capacity) {
        if (!demi_bodies_room(w, sets, (size_t)w->bodies.count, room)) return 0;
        w->bodies.capacity = (int)room;
    }
    if (slots > (size_t)w->bodies.slot_capacity) {
        const size_t slot_room = DEMI_MAX(slots, (size_t)w->bodies.slot_capacity*5/4 + 16);
        if (!demi_bodies_room(w, 1 << DEMI_SLOTS, (size_t)w->bodies.slot_count,
                              slot_room)) return 0;
        w->bodies.slot_capacity = (int)slot_room;
    }
    return 1;
}
/* All that body i keeps becomes 0. */
static void demi_body_clear(dem_world *w, int i) {
    int k;
    for (k = 0; k < DEMI_BODY_ARRAYS; k++) {
        const demi_body_array *a = &demi_body_arrays[k];
        if (demi_keeps(w, a))
            memset(demi_datum(w, a, i), 0, a->item);
    }
}
/* All that body `from` keeps, into body `to`. */
static void demi_body_copy(dem_world *w, int from, int to) {
    int k;
    for (k = 0; k < DEMI_BODY_ARRAYS; k++) {
        const demi_body_array *a = &demi_body_arrays[k];
        if (demi_keeps(w, a))
            memcpy(demi_datum(w, a, to), demi_datum(w, a, from), a->item);
    }
}

/* From now on bodies have orientations. 0 when memory ran out; nothing changed then. */
static int demi_orient_begin(dem_world *w) {
    int i;
    if (w->bodies.orienting) return 1;
    if (!demi_bodies_room(w, 1 << DEMI_TURNED, 0, (size_t)w->bodies.capacity)) return 0;
    w->bodies.orienting = 1;
    for (i = 0; i < w->bodies.count; i++) {
        w->bodies.orient[4*i] = 1;
        demi_put(w->bodies.moment + 4*i, demi_moments_of(w, i));
    }
    return 1;
}

/* J, kinetic, of what moves. */
static double demi_body_energy(const dem_world *w, int i) {
    const dem_real *v = w->bodies.vel + 4*i;
    const double m = (double)w->bodies.mass[i];
    if (w->bodies.inv_mass[i] <= 0) return 0;
    return m*(double)(v[0]*v[0] + v[1]*v[1] + v[2]*v[2])/2 +
        (double)demi_dot(demi_angular_of(w, i), demi_at(w->bodies.spin + 4*i))/2;
}

/* What follows from bodies having changed: forces, list and advice must be made anew. */
static void demi_scene_changed(dem_world *w) {
    w->stage.forces_valid = w->stage.dt_valid = w->stage.primed = 0;
}

/* Puts one body at the end of the arrays; room and list have been seen to. */
static uint32_t demi_body_append(dem_world *w, int material, dem_real radius, dem_vec3 x) {
    const int i = w->bodies.count++;
    const double m = demi_sphere_mass(w, material, (double)radius);
    int slot = w->bodies.slot_free;
    /* chain: index = -2 - next */
    if (slot >= 0) w->bodies.slot_free = -2 - w->bodies.slot_index[slot];
    else { slot = w->bodies.slot_count++; w->bodies.slot_generation[slot] = 1; }
    demi_body_clear(w, i);
    demi_put(w->bodies.pos + 4*i, x);
    if (w->desc.planar) w->bodies.pos[4*i + 2] = 0;
    w->bodies.pos[4*i + 3] = radius;
    w->bodies.mass[i] = (dem_real)m;
    w->bodies.inv_mass[i] = (dem_real)(1/m);
    w->bodies.inv_inertia[i] = (dem_real)(1/demi_sphere_inertia(w, m, (double)radius));
    w->bodies.slot[i] = (uint32_t)slot;
    w->bodies.material[i] = material + 1;
    w->bodies.slot_index[slot] = i;
    if (w->bodies.orienting) {
        demi_quat_put(w->bodies.orient + 4*i, dem_quat_make(1, 0, 0, 0));
        demi_put(w->bodies.moment + 4*i, demi_moments_of(w, i));
    }
    w->lll_valid = 0;
    w->bodies.balance.inserted++;
    w->bodies.balance.present++;
    return (uint32_t)slot;
}
/* Do walls of this kind and parts of that one know each other? (>>kept) */
static int demi_touch_known(int kind, int part);
/* body: its slot, -1: it is yet to come. part: what it is. */
static dem_result demi_strangers(dem_world *w, const char *call, int wall, int kind, int body,
                                 int part) {
    char who[32] = "the body";
    if (body >= 0) snprintf(who, sizeof who, "body %d", body + 1);
    return demi_fail(w, DEM_ERROR_ARGUMENT, "%s: wall %d is a %s and %s a%s %s: the two do not "
                     "know each other; make bodies clusters of spheres, or the wall a mesh or a "
                     "resolved profile; nothing was added", call, wall + 1,
                     demi_wall_kinds[kind].name, who, demi_an(demi_shape_rows[part].name),
                     demi_shape_rows[part].name);
}
/* 1 with a sentence when some wall does not know bodies of a shape that are to be added. */
static int demi_walls_strange(dem_world *w, const char *call, int shape) {
    const int part = demi_shape_kind(&w->shapes[shape]);
    int j;
    for (j = 0; j < w->wall_count; j++) {
        const int kind = w->walls[j].kind;
        if (kind == DEMI_WALL_NONE || demi_touch_known(kind, part)) continue;
        demi_strangers(w, call, j, kind, -1, part);
        return 1;
    }
    return 0;
}
/* Makes the body just appended one of a shape, scaled. */
static void demi_body_shape(dem_world *w, int i, int shape, dem_real scale, dem_quat orientation) {
    const demi_shape *as = &w->shapes[shape];
    const double s = (double)scale;
    const double density = (double)w->materials[w->bodies.material[i] - 1].density;
    const double m = density*as->volume*s*s*s;
    w->bodies.shape[i] = shape + 1;
    w->bodies.pos[4*i + 3] = as->radius*scale;
    w->bodies.mass[i] = (dem_real)m;
    w->bodies.inv_mass[i] = (dem_real)(1/m);
    w->bodies.inv_inertia[i] = 0;
    demi_put(w->bodies.moment + 4*i, demi_moments_of(w, i));
    w->bodies.moment[4*i + 3] = as->moment_arm*scale;
    demi_quat_put(w->bodies.orient + 4*i, demi_quat_unit(dem_quat_times(orientation, as->frame)));
    w->bodies.shaped++;
}

DEM_API dem_result dem_spheres_add(dem_world *w, dem_material material, int count,
                                   const dem_real *positions,
                                   const dem_real *velocities, const dem_real *radii,
                                   dem_real radius) {
    if (demi_null(w, "dem_spheres_add", w, "world")) return DEM_ERROR_ARGUMENT;
    int i, m = 0;
    if (demi_material_index(w, "dem_spheres_add", material,
                            &m) != DEM_OK) return DEM_ERROR_ARGUMENT;
    if (count < 0 || (count > 0 && !positions))
        return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_spheres_add: count is %d, must be >= 0 with "
                         "positions (count x 3)"
                         "; check the caller's array", count);
    for (i = 0; i < count; i++) {
        const dem_real r = radii ? radii[i] : radius;
        if (!(r > 0) || !demi_finite(r))
            return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_spheres_add: radius of sphere %d is %g, "
                             "must be > 0 m; "
                             "no sphere was added", i, (double)r);
        if (demi_mass_refuse(w, "dem_spheres_add", m, r, i)) return DEM_ERROR_ARGUMENT;
        if (!demi_place(demi_at(positions + 3*i)) || (velocities &&
                                                      !demi_finite3(demi_at(velocities + 3*i))))
            return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_spheres_add: position or velocity of "
                             "sphere %d is not a finite number, or the position is farther than "
                             "%g m from the origin; check the data it came from; no sphere was "
                             "added", i, DEMI_FARTHEST);
    }
    if (!demi_list_drop(w) || !demi_bodies_reserve(w, (size_t)w->bodies.count + (size_t)count))
        return demi_no_memory(w, "dem_spheres_add");
    for (i = 0; i < count; i++) {
        const uint32_t slot = demi_body_append(w, m, radii ? radii[i] : radius,
                                               demi_at(positions + 3*i));
        const int k = w->bodies.slot_index[slot];
        if (velocities) demi_put(w->bodies.vel + 4*k, demi_at(velocities + 3*i));
        if (w->desc.planar) w->bodies.vel[4*k + 2] = 0;
        demi_put(w->bodies.half_vel + 4*k, demi_at(w->bodies.vel + 4*k));
        w->booked.inserted += demi_body_energy(w, k);
    }
    demi_scene_changed(w);
    demi_built(w, "dem_spheres_add");
    return DEM_OK;
}

DEM_API dem_body dem_sphere_add(dem_world *w, dem_material material, dem_real radius,
                                dem_vec3 position) {
    if (demi_null(w, "dem_sphere_add", w, "world")) return demi_no_body;
    dem_body id;
    dem_real x[3];
    id.slot = id.generation = 0;
    demi_put(x, position);
    if (dem_spheres_add(w, material, 1, x, 0, 0, radius) != DEM_OK) return id;
    return dem_bodies_id(w, w->bodies.count - 1);
}

/* 0 with a sentence when an array for bodies has a bad value. */
static int demi_bodies_check(dem_world *w, const char *call, int count, const dem_real *x,
                             const dem_real *q, const dem_real *v, const dem_real *spin,
                             const dem_real *scale) {
    int i;
    if (count < 0 || (count > 0 && !x)) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "%s: count is %d, must be >= 0 with positions "
                  "(count x 3); check the caller's array", call, count);
        return 0;
    }
    for (i = 0; i < count; i++) {
        const dem_quat o = q ? demi_quat_at(q + 4*i) : dem_quat_make(1, 0, 0, 0);
        if (!demi_place(demi_at(x + 3*i)) || (v && !demi_finite3(demi_at(v + 3*i))) ||
            (spin && !demi_finite3(demi_at(spin + 3*i)))) {
            demi_fail(w, DEM_ERROR_ARGUMENT, "%s: position, velocity or spin of body %d is not a "
                      "finite number, or the position is farther than %g m from the origin; check "
                      "the data it came from; no body was added", call, i, DEMI_FARTHEST);
            return 0;
        }
        if (!demi_quat_finite(o) || !(demi_quat_most(o) > 0)) {
            demi_fail(w, DEM_ERROR_ARGUMENT, "%s: orientation of body %d is (%g, %g, %g, %g), must "
                      "be finite and not zero; (1, 0, 0, 0) does not turn it; no body was added",
                      call, i, (double)o.w, (double)o.x, (double)o.y, (double)o.z);
            return 0;
        }
        if (scale && !(demi_finite(scale[i]) && scale[i] > 0)) {
            demi_fail(w, DEM_ERROR_ARGUMENT, "%s: scale of body %d is %g, must be > 0; no body "
                      "was added", call, i, (double)scale[i]);
            return 0;
        }
    }
    return 1;
}
/* 1 with a sentence when a body of a shape, scaled, would weigh nothing or too much. */
static int demi_shape_mass_refuse(dem_world *w, const char *call, int material, int shape,
                                  dem_real scale, int i) {
    const double s = (double)scale, density = (double)w->materials[material].density;
    const double m = density*w->shapes[shape].volume*s*s*s;
    const dem_vec3 I = w->shapes[shape].inertia;
    const double least = m*s*s*(double)DEMI_MIN(I.x, DEMI_MIN(I.y, I.z));
    const double most = m*s*s*(double)DEMI_MAX(I.x, DEMI_MAX(I.y, I.z));
    const dem_real six[] = {(dem_real)m, (dem_real)(1/m), (dem_real)least, (dem_real)(1/least),
                            (dem_real)most, (dem_real)(1/most)};
    int k, bad = !demi_finite_double(m) || !(m > 0);
    for (k = 0; k < 6 && !bad; k++) bad = !demi_finite(six[k]) || !(six[k] > 0);
    if (bad)
        demi_fail(w, DEM_ERROR_ARGUMENT, "%s: body %d has scale %g and a mass of %g kg: it or its "
                  "inertia is too small or too large to calculate with in %s precision; lengths "
                  "are in metres: check the unit; nothing was added", call, i, s, m,
                  DEMI_SINGLE ? "single" : "double");
    return bad;
}
/* All that may be refused comes first, then the one place where memory may run out, then what
   cannot fail: so a refused call adds nobody. */
static dem_result demi_bodies_add(dem_world *w, const char *call, dem_material material,
                                  dem_shape shape, int count, const dem_real *positions,
                                  const dem_real *orientations, const dem_real *velocities,
                                  const dem_real *spins, const dem_real *scales) {
    int i, m = 0, f;
    if (demi_material_index(w, call, material, &m) != DEM_OK ||
        (f = demi_shape_index(w, call, shape)) < 0 ||
        !demi_bodies_check(w, call, count, positions, orientations, velocities, spins, scales) ||
        demi_walls_strange(w, call, f))
        return DEM_ERROR_ARGUMENT;
    for (i = 0; i < count; i++)
        if (demi_shape_mass_refuse(w, call, m, f, scales ? scales[i] : 1, i))
            return DEM_ERROR_ARGUMENT;
    if (!demi_list_drop(w) || !demi_bodies_reserve(w, (size_t)w->bodies.count + (size_t)count) ||
        !demi_orient_begin(w)) return demi_no_memory(w, call);
    for (i = 0; i < count; i++) {
        const uint32_t slot = demi_body_append(w, m, 1, demi_at(positions + 3*i));
        const int k = w->bodies.slot_index[slot];
        demi_body_shape(w, k, f, scales ? scales[i] : 1, orientations
                        ? demi_quat_unit(demi_quat_at(orientations + 4*i))
                        : dem_quat_make(1, 0, 0, 0));
        if (velocities) demi_put(w->bodies.vel + 4*k, demi_at(velocities + 3*i));
        if (spins) demi_put(w->bodies.spin + 4*k, demi_at(spins + 3*i));
        demi_put(w->bodies.half_vel + 4*k, demi_at(w->bodies.vel + 4*k));
        demi_put(w->bodies.half_spin + 4*k, demi_at(w->bodies.spin + 4*k));
        demi_put(w->bodies.angular + 4*k, demi_angular_of(w, k));
        w->booked.inserted += demi_body_energy(w, k);
    }
    demi_scene_changed(w);
    demi_built(w, call);
    return DEM_OK;
}
DEM_API dem_result dem_bodies_add(dem_world *w, dem_material material, dem_shape shape, int count,
                                  const dem_real *positions, const dem_real *orientations,
                                  const dem_real *velocities, const dem_real *spins,
                                  const dem_real *scales) {
    if (demi_null(w, "dem_bodies_add", w, "world")) return DEM_ERROR_ARGUMENT;
    return demi_bodies_add(w, "dem_bodies_add", material, shape, count, positions, orientations,
                           velocities, spins, scales);
}
DEM_API dem_body dem_body_add(dem_world *w, dem_material material, dem_shape shape,
                              dem_vec3 position, dem_quat orientation) {
    if (demi_null(w, "dem_body_add", w, "world")) return demi_no_body;
    dem_body id;
    dem_real x[3], q[4];
    id.slot = id.generation = 0;
    demi_put(x, position);
    demi_quat_put(q, orientation);
    if (demi_bodies_add(w, "dem_body_add", material, shape, 1, x, q, 0, 0, 0) != DEM_OK) return id;
    return dem_bodies_id(w, w->bodies.count - 1);
}

/* Index of a body, or -1 with a sentence. */
static int demi_body_index(dem_world *w, const char *call, dem_body b) {
    if (b.slot < 1 || b.slot > (uint32_t)w->bodies.slot_count ||
        w->bodies.slot_generation[b.slot - 1] != b.generation ||
        w->bodies.slot_index[b.slot - 1] < 0) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "%s: body %u (generation %u) does not exist; it was "
                  "removed, has left the "
                  "domain, or never was", call, (unsigned)b.slot, (unsigned)b.generation);
        return -1;
    }
    return w->bodies.slot_index[b.slot - 1];
}

/* The last body moves to the place that becomes free. The slot rests until the next list is made
   (demi_slots_release): contact memory on its way still names it. Its generation goes up, so that
   ids of old find nobody. */
static void demi_body_take_out(dem_world *w, int i) {
    const int last = w->bodies.count - 1, slot = (int)w->bodies.slot[i];
    w->booked.removed += demi_body_energy(w, i);
    if (demi_shape_of(w, i)) w->bodies.shaped--;
    if (i != last) {
        demi_body_copy(w, last, i);
        w->bodies.slot_index[w->bodies.slot[i]] = i;
    }
    w->bodies.slot_index[slot] = -2 - w->bodies.slot_pending;
    w->bodies.slot_pending = slot;
    w->bodies.slot_generation[slot]++;
    w->lll_valid = 0;
    w->bodies.count = last;
    w->bodies.balance.present--;
}

DEM_API dem_result dem_body_remove(dem_world *w, dem_body body) {
    if (demi_null(w, "dem_body_remove", w, "world")) return DEM_ERROR_ARGUMENT;
    int i = demi_body_index(w, "dem_body_remove", body);
    if (i < 0) return DEM_ERROR_ARGUMENT;
    if (!demi_list_drop(w)) return demi_no_memory(w, "dem_body_remove");
    demi_body_take_out(w, i);
    w->bodies.balance.removed++;
    demi_scene_changed(w);
    return DEM_OK;
}

DEM_API dem_result dem_body_get(const dem_world *world, dem_body body, dem_body_state *s) {
    if (demi_null(world, "dem_body_get", s, "state")) return DEM_ERROR_ARGUMENT;
    dem_world *w = (dem_world *)world;
    demi_periods p;
    int i = demi_body_index(w, "dem_body_get", body);
    if (i < 0) return DEM_ERROR_ARGUMENT;
    p = demi_periods_of(w);
    s->position = demi_place_of(&p, demi_at(w->bodies.pos + 4*i));
    s->velocity = demi_at(w->bodies.vel + 4*i);
    s->spin = demi_at(w->bodies.spin + 4*i);
    s->force = demi_at(w->bodies.force + 4*i);
    s->torque = demi_at(w->bodies.torque + 4*i);
    s->radius = w->bodies.pos[4*i + 3];
    s->mass = w->bodies.mass[i];
    s->moments = demi_moments_of(w, i);
    s->inertia = DEMI_MIN(s->moments.x, DEMI_MIN(s->moments.y, s->moments.z));
    s->material.id = w->bodies.material[i];
    s->fixed = w->bodies.inv_mass[i] <= 0;
    s->shape.id = w->bodies.orienting ? w->bodies.shape[i] : 0;
    s->orientation = dem_quat_make(1, 0, 0, 0);
    if (w->bodies.orienting) s->orientation = demi_quat_at(w->bodies.orient + 4*i);
    if (demi_shape_of(w, i))                     /* as its user gave it */
        s->orientation = dem_quat_times(s->orientation,
                                        demi_quat_conjugate(demi_shape_of(w, i)->frame));
    return DEM_OK;
}

DEM_API dem_result dem_body_set(dem_world *w, dem_body body, const dem_body_state *s) {
    if (demi_null(w, "dem_body_set", s, "state")) return DEM_ERROR_ARGUMENT;
    int i = demi_body_index(w, "dem_body_set", body);
    const demi_shape *shape;
    const dem_quat q = s->orientation;
    double before, m;
    if (i < 0) return DEM_ERROR_ARGUMENT;
    shape = demi_shape_of(w, i);
    if (w->bodies.orienting && (!demi_quat_finite(q) || !(demi_quat_most(q) > 0)))
        return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_body_set: orientation of body %u is (%g, %g, "
                         "%g, %g), must be finite and not zero; fill the state with dem_body_get "
                         "first", (unsigned)body.slot, (double)q.w, (double)q.x, (double)q.y,
                         (double)q.z);
    if (!demi_place(s->position) || !demi_finite3(s->velocity) || !demi_finite3(s->spin))
        return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_body_set: position, velocity or spin of body "
                         "%u is not a finite number, or the position is farther than %g m from the "
                         "origin; check what it was computed from", (unsigned)body.slot,
                         DEMI_FARTHEST);
    if (!demi_list_drop(w)) return demi_no_memory(w, "dem_body_set");
    before = demi_body_energy(w, i);
    m = (double)w->bodies.mass[i];
    demi_put(w->bodies.pos + 4*i, s->position);
    demi_put(w->bodies.vel + 4*i, s->velocity);
    demi_put(w->bodies.spin + 4*i, s->spin);
    if (w->desc.planar)
        w->bodies.pos[4*i + 2] = w->bodies.vel[4*i + 2] = w->bodies.spin[4*i] =
            w->bodies.spin[4*i + 1] = 0;
    /* never moves, whatever it is told */
    if (s->fixed) demi_put(w->bodies.vel + 4*i, demi_v(0, 0, 0));
    if (s->fixed) demi_put(w->bodies.spin + 4*i, demi_v(0, 0, 0));
    demi_put(w->bodies.half_vel + 4*i, demi_at(w->bodies.vel + 4*i));
    demi_put(w->bodies.half_spin + 4*i, demi_at(w->bodies.spin + 4*i));
    w->bodies.inv_mass[i] = s->fixed ? 0 : (dem_real)(1/m);
    w->bodies.inv_inertia[i] = s->fixed || shape ? 0 : (dem_real)(1/demi_sphere_inertia(w, m,
        (double)w->bodies.pos[4*i + 3]));
    if (w->bodies.orienting) {
        demi_quat_put(w->bodies.orient + 4*i,
                      demi_quat_unit(shape ? dem_quat_times(q, shape->frame) : q));
        demi_put(w->bodies.angular + 4*i, demi_angular_of(w, i));
    }
    w->booked.inserted += demi_body_energy(w, i) - before;
    demi_scene_changed(w);
    return DEM_OK;
}

DEM_API dem_bodies dem_bodies_get(const dem_world *w) {
    dem_bodies b;
    memset(&b, 0, sizeof b);
    if (!w) return b;
    b.count = w->bodies.count;
    b.positions = demi_wrapped(w);
    b.velocities = w->bodies.vel;
    b.spins = w->bodies.spin;
    b.forces = w->bodies.force;
    b.torques = w->bodies.torque;
    b.masses = w->bodies.mass; b.slots = w->bodies.slot; b.materials = w->bodies.material;
    b.orientations = w->bodies.orient;
    b.shapes = w->bodies.shape;
    return b;
}
DEM_API dem_body dem_bodies_id(const dem_world *w, int index) {
    if (demi_null(w, "dem_bodies_id", w, "world")) return demi_no_body;
    dem_body id;
    id.slot = id.generation = 0;
    if (index < 0 || index >= w->bodies.count) return id;
    id.slot = w->bodies.slot[index] + 1;
    id.generation = w->bodies.slot_generation[w->bodies.slot[index]];
    return id;
}
DEM_API dem_balance dem_balance_get(const dem_world *w) {
    dem_balance none;
    memset(&none, 0, sizeof none);
    return w ? w->bodies.balance : none;
}


/* ---------------------------------------------------------------------------------------------
   >>facets
   What each face, edge and corner of a surface counts, so that a grain feels the surface and not
   the way it is cut into facets. Meshes (triangles) and profiles (segments) are surfaces of facets.

   A grain of radius r whose centre x is at distance d from a wall stores U(r - d), U the energy of
   the normal law. A ball about x, whose radius s grows from 0 to r, meets the surface S first in
   one place, perhaps then in others; as s grows on they join. Let chi(s) be Euler's number of what
   ball and surface have in common: pieces, less rings. The rule is
       E(x) = integral of chi(s) dU(r - s),  s = 0 .. r          F = -dE/dx
   One place counts once; two that have joined count once, two that have not count twice. chi adds:
       chi(A or B) = chi(A) + chi(B) - chi(A and B)
   and it is 1 for whatever is convex. So, over the faces, edges and corners X of the surface, each
   convex and closed, at distance d(X) from x,
       E = sum of weight(X) U(r - d(X)),     F = -sum of weight(X) U'(r - d(X)) grad d(X)
       face 1,  edge 1 - (faces at it),  corner 1 - (faces at it) - sum of weights of edges at it
   in words: every point of the surface is counted once in all. Cutting a facet in two changes
   nothing. E is an energy: elastic contacts conserve, whatever the surface. The distance to
   something convex has a continuous gradient, so F has no jump on any path outside the surface. In
   the open, on a ridge, at a rim or a tip one place is nearest and U' there is all that is left:
   what a plane and a cylinder give. In a valley there are two nearest places and the edge between,
   which counts -1: F goes from one contact to two as the valley gets steeper or the overlap less.
   (In Morse's words: F is a sum over the critical points of the distance, lowest points 1, passes
   -1.) Terms with the same nearest point are added up before the law is called; most of them
   cancel, and what is left is, nearly always, one contact. Where a ring closes around the grain chi
   is 0; what is done then stands in >>touch.

   The law, its friction and its memory are asked at each place that is left, and counted as often
   as it counts. What two walls have in common is found where they do not move against each other;
   each bears its part of the weight. Left as they are, so that contacts add up, as they do in a
   corner: facets that pierce each other or overlap in one plane, cracks, and seams between walls of
   different kinds. That Euler's number adds is old; as a rule of contact we have not found it
   published. Tests: tests/test_facets.c.
   --------------------------------------------------------------------------------------------- */
DEM_INLINE int demi_wall_is(const demi_wall *wall, int trait) {
    return (demi_wall_kinds[wall->kind].traits & trait) != 0;
}
DEM_INLINE int demi_faceted(const demi_wall *wall) { return demi_wall_is(wall, DEMI_FACETS); }
DEM_INLINE int demi_wall_per(const demi_wall *wall) { return demi_wall_kinds[wall->kind].corners; }

static double demi_far2(const double *a, const double *b) {
    const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return x*x + y*y + z*z;
}

/* Points in a tree of boxes, to find those near a line. Node k has the halves 2k + 1 and 2k + 2,
   cut across its longest side; each has a stretch of `order` and the box around its points. */
enum { DEMI_TREE_LEAF = 8 };
typedef struct demi_tree {
    const double *x;               /* points x 3, m: the caller's */
    int32_t *order;                /* points */
    double *box;                   /* nodes x 6: lowest and highest x, y, z */
    size_t points, nodes;
} demi_tree;
/* A search along the line from a to b: nodes not yet looked into, and the leaf under work. */
typedef struct demi_search_line {
    const demi_tree *tree;
    const double *a, *b;
    double off;                    /* m, how far from the line a point may be */
    int32_t node[64], from[64], to[64];
    int open, at, end;
} demi_search_line;

/* Puts the k-th point along an axis in its place, none above it before it [HOA61]. */
static void demi_tree_select(const double *x, int axis, int32_t *order, int count, int k) {
    int lo = 0, hi = count - 1;
    while (lo < hi) {
        const double pivot = x[3*order[k] + axis];
        int i = lo, j = hi;
        while (i <= j) {
            while (x[3*order[i] + axis] < pivot) i++;
            while (x[3*order[j] + axis] > pivot) j--;
            if (i <= j) {
                const int32_t keep = order[i];
                order[i++] = order[j];
                order[j--] = keep;
            }
        }
        if (j < k) lo = i;
        if (i > k) hi = j;
    }
}
/* The box of points from .. to - 1 of the order, halved across its longest side until few are
   left. */
static void demi_tree_node(demi_tree *t, size_t node, int from, int to) {
    double *box = t->box + 6*node;
    const int mid = from + (to - from)/2;
    int i, k, axis = 0;
    for (k = 0; k < 3; k++) {
        box[k] = box[3 + k] = t->x[3*t->order[from] + k];
        for (i = from + 1; i < to; i++) {
            box[k] = DEMI_MIN(box[k], t->x[3*t->order[i] + k]);
            box[3 + k] = DEMI_MAX(box[3 + k], t->x[3*t->order[i] + k]);
        }
        if (box[3 + k] - box[k] > box[3 + axis] - box[axis]) axis = k;
    }
    if (to - from <= DEMI_TREE_LEAF) return;
    demi_tree_select(t->x, axis, t->order + from, to - from, mid - from);
    demi_tree_node(t, 2*node + 1, from, mid);
    demi_tree_node(t, 2*node + 2, mid, to);
}
static void demi_tree_free(dem_world *w, demi_tree *t) {
    demi_free(w, t->order);
    demi_free(w, t->box);
}
/* 0 when memory ran out; free it even then. */
static int demi_tree_make(dem_world *w, demi_tree *t, const double *x, int count) {
    int i;
    t->x = x;
    t->points = (size_t)count;
    for (t->nodes = 1, i = count; i > DEMI_TREE_LEAF; i = i - i/2) t->nodes = 2*t->nodes + 1;
    t->order = (int32_t *)demi_alloc(w, t->points, sizeof *t->order);
    t->box = (double *)demi_alloc(w, t->nodes*6, sizeof *t->box);
    if (!t->order || !t->box) return !count;
    for (i = 0; i < count; i++) t->order[i] = i;
    if (count) demi_tree_node(t, 0, 0, count);
    return 1;
}
/* Has the line from a to b a part within `off` of the box? More rather than less near its edges. */
static int demi_line_meets(const double *a, const double *b, double off, const double *box) {
    double enter = 0, leave = 1;
    int k;
    for (k = 0; k < 3; k++) {
        const double lo = box[k] - off - a[k], hi = box[3 + k] + off - a[k], way = b[k] - a[k];
        if (way > 0 || way < 0) {
            enter = DEMI_MAX(enter, (way > 0 ? lo : hi)/way);
            leave = DEMI_MIN(leave, (way > 0 ? hi : lo)/way);
        } else if (lo > 0 || hi < 0) return 0;
    }
    return enter <= leave*(1 + 1e-12) + 1e-300;
}
/* Begins to look for points within `off` of the line from a to b. */
static void demi_tree_line(demi_search_line *s, const demi_tree *t, const double *a,
                           const double *b, double off) {
    s->tree = t;
    s->a = a;
    s->b = b;
    s->off = off;
    s->open = t->points > 0;
    s->node[0] = s->from[0] = 0;
    s->to[0] = (int32_t)t->points;
    s->at = s->end = 0;
}
/* The next point that may be near the line, -1 after the last; no point that is near is missing. */
static int32_t demi_tree_next(demi_search_line *s) {
    while (s->at == s->end) {
        int32_t node, from, to;
        if (!s->open) return -1;
        node = s->node[--s->open];
        from = s->from[s->open];
        to = s->to[s->open];
        if (!demi_line_meets(s->a, s->b, s->off, s->tree->box + 6*node)) continue;
        if (to - from <= DEMI_TREE_LEAF) {
            s->at = from;
            s->end = to;
        } else {
            s->node[s->open] = 2*node + 2;
            s->from[s->open] = from + (to - from)/2;
            s->to[s->open++] = to;
            s->node[s->open] = 2*node + 1;
            s->from[s->open] = from;
            s->to[s->open++] = from + (to - from)/2;
        }
    }
    return s->tree->order[s->at++];
}

/* How far from each corner's point another may be and yet be the same, m: a few roundings of the
   largest coordinate, as binary STL stores it, but far less than the shortest side there. */
static void demi_near_by(const double *x, const demi_wall *wall, int first, double *near_by) {
    const int per = demi_wall_per(wall);
    double most = 0;
    int i, k;
    for (i = 0; i < wall->vertex_count; i++) near_by[first + i] = 0;       /* if no corner's */
    for (i = 0; i < per*wall->element_count; i++)
        for (k = 0; k < 3; k++) most = DEMI_MAX(most, fabs(x[3*(first + wall->corners[i]) + k]));
    for (i = 0; i < per*wall->element_count; i++)
        near_by[first + wall->corners[i]] = 4*(double)FLT_EPSILON*most;
    for (i = 0; i < wall->element_count; i++)
        for (k = 0; k < per; k++) {
            const int a = first + wall->corners[per*i + k];
            const int b = first + wall->corners[per*i + (k + 1)%per];
            const double side = 1e-3*sqrt(demi_far2(x + 3*a, x + 3*b));
            if (!(side > 0)) continue;
            near_by[a] = DEMI_MIN(near_by[a], side);
            near_by[b] = DEMI_MIN(near_by[b], side);
        }
}
/* same[i]: the first point that lies where point i does. */
static void demi_points_weld(const demi_tree *tree, const double *near_by, int32_t *same) {
    const double *x = tree->x;
    const int count = (int)tree->points;
    demi_search_line near;
    int i;
    for (i = 0; i < count; i++) same[i] = i;
    for (i = 0; i < count; i++) {
        int32_t a, b, other;
        /* a copy of a point before it: that one has met all whom it would meet */
        if (same[i] != i && near_by[i] <= near_by[same[i]] &&
            !(demi_far2(x + 3*i, x + 3*same[i]) > 0)) continue;
        demi_tree_line(&near, tree, x + 3*i, x + 3*i, near_by[i]);
        while ((other = demi_tree_next(&near)) >= 0) {
            const double most = DEMI_MIN(near_by[i], near_by[other]);
            if (other <= i || !(demi_far2(x + 3*i, x + 3*other) <= most*most)) continue;
            for (a = i; same[a] != a;) a = same[a];
            for (b = other; same[b] != b;) b = same[b];
            same[DEMI_MAX(a, b)] = DEMI_MIN(a, b);
        }
    }
    for (i = 0; i < count; i++) same[i] = same[same[i]];
}
/* Does a facet count? Not with two corners in one place; nor a triangle with none off its longest
   side by more than what is one place there: its other sides and corners are its neighbours'. */
static int demi_facet_counts(const double *x, const double *near_by, const int32_t *c, int per) {
    double side[3], longest, most, area2 = 0, u[3], v[3];
    int k;
    if (c[0] == c[1]) return 0;
    if (per == 2) return 1;
    if (c[1] == c[2] || c[2] == c[0]) return 0;
    for (k = 0; k < 3; k++) {
        side[k] = demi_far2(x + 3*c[k], x + 3*c[(k + 1)%3]);
        u[k] = x[3*c[1] + k] - x[3*c[0] + k];
        v[k] = x[3*c[2] + k] - x[3*c[0] + k];
    }
    for (k = 0; k < 3; k++) {
        const double n = u[(k + 1)%3]*v[(k + 2)%3] - u[(k + 2)%3]*v[(k + 1)%3];
        area2 += n*n;
    }
    longest = DEMI_MAX(side[0], DEMI_MAX(side[1], side[2]));
    most = DEMI_MIN(near_by[c[0]], DEMI_MIN(near_by[c[1]], near_by[c[2]]));
    return area2 > most*most*longest;
}

/* A side of a facet, from point lo to point hi. */
typedef struct demi_side { int32_t lo, hi, facet, side; } demi_side;
/* Sides between the same corners come next to each other, the lowest facet first. */
static int demi_side_compare(const void *x, const void *y) {
    const demi_side *a = (const demi_side *)x, *b = (const demi_side *)y;
    if (a->lo != b->lo) return a->lo < b->lo ? -1 : 1;
    if (a->hi != b->hi) return a->hi < b->hi ? -1 : 1;
    if (a->facet != b->facet) return a->facet < b->facet ? -1 : 1;
    return a->side < b->side ? -1 : a->side > b->side;
}
/* A side has no direction: its corners in ascending order. */
static demi_side demi_side_of(int32_t a, int32_t b, int facet, int side) {
    demi_side s;
    s.lo = DEMI_MIN(a, b);
    s.hi = DEMI_MAX(a, b);
    s.facet = facet;
    s.side = side;
    return s;
}

/* The planes of a wall's elements, by which most that a body does not reach are told at once. */
static void demi_facet_planes(demi_wall *wall, const double *x) {
    const int n = demi_wall_per(wall);
    double far = 0;
    int i, k;
    for (i = 0; i < 3*wall->vertex_count; i++) far = DEMI_MAX(far, fabs(x[i]));
    wall->plane_slack = (dem_real)(16*far*(DEMI_SINGLE ? (double)FLT_EPSILON : DBL_EPSILON));
    for (i = 0; i < wall->element_count; i++) {
        const double *a = x + 3*wall->corners[n*i], *b = x + 3*wall->corners[n*i + 1];
        double u[3], v[3], m[3], l;
        for (k = 0; k < 3; k++) u[k] = b[k] - a[k];
        for (k = 0; k < 3; k++) v[k] = n == 3 ? x[3*wall->corners[n*i + 2] + k] - a[k] : k == 2;
        if (n == 2) u[2] = 0;                   /* a segment goes on along z without end */
        for (k = 0; k < 3; k++) m[k] = u[(k + 1)%3]*v[(k + 2)%3] - u[(k + 2)%3]*v[(k + 1)%3];
        l = sqrt(m[0]*m[0] + m[1]*m[1] + m[2]*m[2]);
        if (!(l*l > 1e-8*(u[0]*u[0] + u[1]*u[1] + u[2]*u[2])*
                    (v[0]*v[0] + v[1]*v[1] + v[2]*v[2]))) continue;
        for (k = 0; k < 3; k++) wall->planes[4*i + k] = (dem_real)(m[k]/l);
        wall->planes[4*i + 3] = (dem_real)((m[0]*a[0] + m[1]*a[1] + m[2]*a[2])/l);
    }
}
/* Welds a wall's corners, numbers its edges and says which element looks after which. Elements
   that have two corners in one place count nothing. 0 when memory ran out. */
static int demi_facets_begin(dem_world *w, demi_wall *wall) {
    const int n = demi_wall_per(wall), all = wall->element_count;
    const size_t vertices = (size_t)wall->vertex_count;
    double *x = (double *)demi_alloc(w, vertices*3, sizeof *x);
    int32_t *same = (int32_t *)demi_alloc(w, vertices, sizeof *same);
    demi_side *sides = (demi_side *)demi_alloc(w, (size_t)all*3, sizeof *sides);
    double *near_by = (double *)demi_alloc(w, vertices, sizeof *near_by);
    demi_tree tree;
    int i, k, count = 0, ok = 0;
    memset(&tree, 0, sizeof tree);
    wall->owns = (unsigned char *)demi_hold(w, DEMI_SCENE, (size_t)all, 1);
    wall->edges = (int32_t *)demi_hold(w, DEMI_SCENE, (size_t)all*3, sizeof(int32_t));
    wall->planes = (dem_real *)demi_hold(w, DEMI_SCENE, (size_t)all*4, sizeof(dem_real));
    if (!x || !same || !sides || !near_by || !wall->owns || !wall->edges || !wall->planes)
        goto done;
    for (i = 0; i < 3*wall->vertex_count; i++) x[i] = (double)wall->vertices[i];
    if (!demi_tree_make(w, &tree, x, wall->vertex_count)) goto done;
    demi_near_by(x, wall, 0, near_by);
    demi_points_weld(&tree, near_by, same);
    for (i = 0; i < n*all; i++) wall->corners[i] = same[wall->corners[i]];
    demi_facet_planes(wall, x);
    memset(same, 0, vertices*sizeof *same);     /* from here on: does an element own it? */
    for (i = 0; i < all; i++) {
        const int32_t *c = wall->corners + n*i;
        if (!demi_facet_counts(x, near_by, c, n)) continue;
        for (k = 0; k < n; k++) {
            if (!same[c[k]]) wall->owns[i] = (unsigned char)(wall->owns[i] | 8 << k);
            same[c[k]] = 1;
            if (n == 3) sides[count++] = demi_side_of(c[k], c[(k + 1)%3], i, k);
        }
    }
    qsort(sides, (size_t)count, sizeof *sides, demi_side_compare);
    for (i = 0; i < count; i++) {
        const demi_side *s = sides + i;
        const int again = i > 0 && s[-1].lo == s->lo && s[-1].hi == s->hi;
        if (!again) {
            wall->owns[s->facet] = (unsigned char)(wall->owns[s->facet] | 1 << s->side);
            wall->edge_count++;
        }
        wall->edges[3*s->facet + s->side] = wall->edge_count - 1;
    }
    wall->weight = (dem_real *)demi_hold(w, DEMI_SCENE,
                                         (size_t)all + (size_t)wall->edge_count + vertices,
                                          sizeof(dem_real));
    ok = wall->weight != 0;
done:
    demi_free(w, x);
    demi_tree_free(w, &tree);
    demi_free(w, same);
    demi_free(w, sides);
    demi_free(w, near_by);
    return ok;
}

/* Does any element count? The first that does looks after its corners. */
static int demi_facets_any(const demi_wall *wall) {
    int i;
    for (i = 0; i < wall->element_count; i++) if (wall->owns[i]) return 1;
    return 0;
}

/* 1 when the two walls stay where they are to each other: both fixed, or moved alike. */
static int demi_walls_together(const demi_wall *a, const demi_wall *b) {
    const dem_motion *m = &a->motion, *o = &b->motion;
    if (a == b) return 1;
    if (m->kind != o->kind || m->kind == DEM_MOTION_USER) return 0;
    if (m->kind == DEM_MOTION_FIXED) return 1;
    if (memcmp(&m->start, &o->start, sizeof m->start) ||
        memcmp(&m->velocity, &o->velocity, sizeof m->velocity)) return 0;
    return m->kind == DEM_MOTION_TRANSLATING ? 1 : m->kind == DEM_MOTION_ROTATING
        ? !memcmp(&m->point, &o->point, sizeof m->point) &&
          !memcmp(&m->axis, &o->axis, sizeof m->axis) &&
          !memcmp(&m->speed, &o->speed, sizeof m->speed)
        : !memcmp(&m->amplitude, &o->amplitude, sizeof m->amplitude) &&
          !memcmp(&m->frequency, &o->frequency, sizeof m->frequency) &&
          !memcmp(&m->phase, &o->phase, sizeof m->phase);
}

/* --- walls across periodic faces. A wall that is not longer than the period along a periodic axis
       repeats there: bodies look for it at their own images, and where it ends just where its image
       begins the two are one surface. One that is longer stands for all its images and must reach
       a grain beyond both faces. Endless walls are their own images. --- */
static void demi_extent_add(dem_real *lo, dem_real *hi, dem_vec3 x, dem_real pad) {
    dem_real at[3];
    int k;
    demi_put(at, x);
    for (k = 0; k < 3; k++) {
        lo[k] = DEMI_MIN(lo[k], at[k] - pad);
        hi[k] = DEMI_MAX(hi[k], at[k] + pad);
    }
}
/* From where to where a wall with ends goes along the axes of the world, where it is now. */
static void demi_wall_span(demi_wall *wall) {
    const dem_pose *p = &wall->pose;
    const dem_real pad = demi_wall_is(wall, DEMI_BALLS) ? wall->radius : 0;
    const dem_real far = DEMI_SINGLE ? DEM_R(FLT_MAX) : (dem_real)DBL_MAX;
    dem_real lo[3] = {far, far, far}, hi[3] = {-far, -far, -far};
    int i;
    for (i = 0; i < wall->vertex_count; i++)
        demi_extent_add(lo, hi, demi_add(p->position, demi_rotate(p->rotation,
                                        demi_at(wall->vertices + 3*i))), pad);
    if (!wall->vertex_count) demi_extent_add(lo, hi, p->position, wall->extent);
    if (demi_wall_is(wall, DEMI_DRAWN)) {
        lo[2] = -far/4;
        hi[2] = far/4;
    }
    memcpy(wall->span_lo, lo, sizeof lo);
    memcpy(wall->span_hi, hi, sizeof hi);
}
/* Says of each wall along which axes it repeats. */
static void demi_walls_repeat(dem_world *w) {
    const demi_periods p = demi_periods_of(w);
    int i, k;
    w->repeating = 0;
    for (k = 0; k < 3; k++) w->wall_period[k] = p.period[k] > 0 ? p.period[k] : w->ring_period[k];
    for (i = 0; i < w->wall_count; i++) {
        demi_wall *wall = &w->walls[i];
        memset(wall->repeats, 0, sizeof wall->repeats);
        if (wall->kind == DEMI_WALL_NONE || wall->extent < 0) continue;
        if (!(w->wall_period[0] > 0 || w->wall_period[1] > 0 || w->wall_period[2] > 0)) continue;
        demi_wall_span(wall);
        for (k = 0; k < 3; k++) {
            const dem_real most = DEMI_MAX(DEMI_ABS(wall->span_lo[k]), DEMI_ABS(wall->span_hi[k]));
            const dem_real slack = 8*(dem_real)FLT_EPSILON*most;
            wall->repeats[k] = w->wall_period[k] > 0 &&
                wall->span_hi[k] - wall->span_lo[k] <= w->wall_period[k] + slack;
            w->repeating |= wall->repeats[k];
        }
    }
}
/* How many periods on, from first[k] to last[k], the images of a place are from which a wall is
   nearer than `far`. */
static void demi_wall_images(const dem_world *w, const demi_wall *wall, dem_vec3 place,
                             dem_real far, int *first, int *last) {
    dem_real x[3];
    int k;
    demi_put(x, place);
    for (k = 0; k < 3; k++) {
        const double period = (double)w->wall_period[k];
        first[k] = last[k] = 0;
        if (!wall->repeats[k]) continue;
        first[k] = (int)ceil((double)(wall->span_lo[k] - far - x[k])/period);
        last[k] = (int)floor((double)(wall->span_hi[k] + far - x[k])/period);
    }
}
static dem_vec3 demi_wall_shift(const dem_world *w, int a, int b, int c) {
    return demi_v((dem_real)a*w->wall_period[0], (dem_real)b*w->wall_period[1],
                  (dem_real)c*w->wall_period[2]);
}

/* The surfaces of a group of walls as one, under work. Points are the corners of all of them, one
   wall after the other, where they were when their motion began (so that a restart finds the same);
   facets are their elements, those left out that have no size. */
typedef struct demi_join {
    int per;                       /* corners of a facet: 3 (meshes) or 2 (profiles) */
    int points, facets, sides, cuts;
    int images;                    /* of facets: the last ones, of no wall, -1 */
    double *x, *near_by;           /* points: x 3; m, what is one place */
    demi_tree tree;                /* of points */
    int32_t *same, *mark;          /* points: the first in this place; for whoever needs it */
    double *faces, *corners;       /* points: facets there, in all and with a corner */
    double *edges;                 /* points: weights of edges that end there */
    double *own;                   /* points: as corners, of one wall */
    int32_t *facet;                /* facets x 5: wall, element, points of its corners */
    double *count;                 /* facets: 1; of those that coincide in n walls 1/n */
    demi_side *side, *piece;       /* as they are, and with cuts: side 3 + k is a piece of side k */
    int32_t *cut;                  /* cuts x 6: wall, element, points, number, side */
    double *cut_weight;
    size_t point_room, facet_room, cut_room;
} demi_join;

/* What was needed to join surfaces; weights, pieces and owners are the walls' own by then. */
static void demi_join_free(dem_world *w, demi_join *j) {
    demi_free(w, j->x);
    demi_free(w, j->near_by);
    demi_tree_free(w, &j->tree);
    demi_free(w, j->same);
    demi_free(w, j->mark);
    demi_free(w, j->faces);
    demi_free(w, j->corners);
    demi_free(w, j->edges);
    demi_free(w, j->own);
    demi_free(w, j->facet);
    demi_free(w, j->count);
    demi_free(w, j->side);
    demi_free(w, j->piece);
    demi_free(w, j->cut);
    demi_free(w, j->cut_weight);
}
static int demi_join_member(const dem_world *w, int wall, int group, int per) {
    const demi_wall *m = &w->walls[wall];
    return demi_faceted(m) && m->group == group && per == demi_wall_per(m);
}
/* Does a wall keep its place to its image along an axis? */
static int demi_wall_keeps(const demi_wall *wall, int axis) {
    const dem_motion *m = &wall->motion;
    const dem_vec3 n = demi_unit(m->axis), e = demi_v(axis == 0, axis == 1, axis == 2);
    return wall->repeats[axis] && (m->kind != DEM_MOTION_ROTATING ||
                                   demi_length(demi_cross(n, e)) <= DEM_R(1e-6));
}
/* Images of facets that touch the group: they count where edges and corners meet them, and get no
   weight themselves. fill 0: counts them, with one point for each corner. */
static void demi_join_images(const dem_world *w, demi_join *j, int group, int fill) {
    double lo[3] = {1e300, 1e300, 1e300}, hi[3] = {-1e300, -1e300, -1e300}, slack = 0;
    int i, e, k, c, n, first = 0;
    if (!w->repeating) return;
    for (i = group; i < w->wall_count; i++)
        for (k = 0; k < 3 && demi_join_member(w, i, group, j->per); k++) {
            lo[k] = DEMI_MIN(lo[k], (double)w->walls[i].span_lo[k]);
            hi[k] = DEMI_MAX(hi[k], (double)w->walls[i].span_hi[k]);
            if (k == 2 && j->per == 2) continue;
            slack = DEMI_MAX(slack, 8*(double)FLT_EPSILON*DEMI_MAX(fabs(lo[k]), fabs(hi[k])));
        }
    for (i = group; i < w->wall_count; i++) {
        const demi_wall *wall = &w->walls[i];
        if (!demi_join_member(w, i, group, j->per)) continue;
        for (n = 0; n < 27; n++) {
            const int s[3] = {n%3 - 1, n/3%3 - 1, n/9 - 1};
            const dem_vec3 by = demi_wall_shift(w, s[0], s[1], s[2]);
            int use = n != 13;
            for (k = 0; k < 3; k++) use = use && (!s[k] || demi_wall_keeps(wall, k));
            for (e = 0; e < wall->element_count && use; e++) {
                double x[9], a = 0, b = 0;
                int near = 1;
                for (c = 0; c < j->per; c++) {
                    const dem_vec3 at = demi_add(by, demi_add(wall->pose.position,
                        demi_rotate(wall->pose.rotation, demi_at(wall->vertices + 3*
                                                               wall->corners[j->per*e + c]))));
                    x[3*c] = (double)at.x; x[3*c + 1] = (double)at.y; x[3*c + 2] = (double)at.z;
                }
                for (k = 0; k < 3; k++) {
                    for (c = 0; c < j->per; c++) {
                        a = c ? DEMI_MIN(a, x[3*c + k]) : x[k];
                        b = c ? DEMI_MAX(b, x[3*c + k]) : x[k];
                    }
                    near = near && a <= hi[k] + slack && b >= lo[k] - slack;
                }
                if (!near) continue;
                if (!fill) {
                    j->point_room += (size_t)j->per;
                    j->facet_room++;
                    continue;
                }
                memcpy(j->x + 3*j->points, x, (size_t)j->per*3*sizeof *x);
                for (c = 0; c < j->per; c++)    /* as it is for the wall's own corners */
                    j->near_by[j->points + c] = j->near_by[first + wall->corners[j->per*e + c]];
                j->points += j->per;
                j->images++;
            }
        }
        first += wall->vertex_count;
    }
}
/* Points and facets of all walls of a group. 0 when memory ran out. */
static int demi_join_begin(dem_world *w, demi_join *j, int group, int per) {
    int i, e, k, first = 0, real_points;
    memset(j, 0, sizeof *j);
    j->per = per;
    for (i = group; i < w->wall_count; i++) {
        if (!demi_join_member(w, i, group, per)) continue;
        j->point_room += (size_t)w->walls[i].vertex_count;
        j->facet_room += (size_t)w->walls[i].element_count;
    }
    demi_join_images(w, j, group, 0);
    if (j->point_room > INT_MAX/8 || j->facet_room > INT_MAX/8) return 0;
    j->x = (double *)demi_alloc(w, j->point_room*3, sizeof(double));
    j->near_by = (double *)demi_alloc(w, j->point_room, sizeof(double));
    j->same = (int32_t *)demi_alloc(w, j->point_room, sizeof(int32_t));
    j->mark = (int32_t *)demi_alloc(w, j->point_room, sizeof(int32_t));
    j->faces = (double *)demi_alloc(w, j->point_room, sizeof(double));
    j->corners = (double *)demi_alloc(w, j->point_room, sizeof(double));
    j->edges = (double *)demi_alloc(w, j->point_room, sizeof(double));
    j->own = (double *)demi_alloc(w, j->point_room, sizeof(double));
    j->facet = (int32_t *)demi_alloc(w, j->facet_room*5, sizeof(int32_t));
    j->count = (double *)demi_alloc(w, j->facet_room, sizeof(double));
    j->side = (demi_side *)demi_alloc(w, j->facet_room*3, sizeof(demi_side));
    if (!j->x || !j->near_by || !j->same || !j->mark || !j->faces || !j->corners ||
        !j->edges || !j->own || !j->facet || !j->count || !j->side) return 0;
    for (i = group; i < w->wall_count; i++) {
        const demi_wall *wall = &w->walls[i];
        if (!demi_join_member(w, i, group, per)) continue;
        for (k = 0; k < wall->vertex_count; k++) {
            const dem_vec3 at = demi_add(wall->home.position, demi_rotate(wall->home.rotation,
                                         demi_at(wall->vertices + 3*k)));
            double *x = j->x + 3*j->points++;
            x[0] = (double)at.x; x[1] = (double)at.y; x[2] = (double)at.z;
        }
        demi_near_by(j->x, wall, first, j->near_by);
        first += wall->vertex_count;
    }
    real_points = j->points;
    demi_join_images(w, j, group, 1);
    first = 0;
    if (!demi_tree_make(w, &j->tree, j->x, j->points)) return 0;
    demi_points_weld(&j->tree, j->near_by, j->same);
    for (i = group; i < w->wall_count; i++) {
        const demi_wall *wall = &w->walls[i];
        if (!demi_join_member(w, i, group, per)) continue;
        for (e = 0; e < wall->element_count; e++) {
            int32_t *f = j->facet + 5*j->facets;
            f[0] = i;
            f[1] = e;
            for (k = 0; k < per; k++) f[2 + k] = j->same[first + wall->corners[per*e + k]];
            if (!demi_facet_counts(j->x, j->near_by, f + 2, per)) continue;
            j->count[j->facets++] = 1;
        }
        first += wall->vertex_count;
    }
    for (i = 0; i < j->images; i++) {
        int32_t *f = j->facet + 5*j->facets;
        f[0] = f[1] = -1;
        for (k = 0; k < per; k++) f[2 + k] = j->same[real_points + per*i + k];
        if (!demi_facet_counts(j->x, j->near_by, f + 2, per)) continue;
        j->count[j->facets++] = 1;
    }
    return 1;
}
/* Facets that coincide, the sides of a box against another's, count once in all: the first of each
   wall, each its part. */
static void demi_join_double(demi_join *j) {
    demi_side *s = j->side;
    int i, k, end;
    for (i = 0; i < j->facets; i++) {
        int32_t c[3];
        for (k = 0; k < 3; k++) c[k] = j->facet[5*i + 2 + (k < j->per ? k : 0)];
        s[i] = demi_side_of(DEMI_MIN(c[0], DEMI_MIN(c[1], c[2])),
                            DEMI_MAX(c[0], DEMI_MAX(c[1], c[2])), 0, i);
        if (j->per == 3) s[i].facet = c[0] + c[1] + c[2] - s[i].lo - s[i].hi;
    }
    qsort(s, (size_t)j->facets, sizeof *s, demi_side_compare);
    for (i = 0; i < j->facets; i = end) {
        int walls = 0;
        for (end = i; end < j->facets && s[end].lo == s[i].lo && s[end].hi == s[i].hi &&
             s[end].facet == s[i].facet; end++) {
            const int wall = j->facet[5*s[end].side];      /* ascending: facets are */
            j->count[s[end].side] = end == i || wall != j->facet[5*s[end - 1].side];
            walls += j->count[s[end].side] > 0;
        }
        for (k = i; k < end; k++) j->count[s[k].side] /= walls;
    }
    for (i = 0; i < j->facets; i++)
        for (k = 0; k < j->per; k++) {
            j->faces[j->facet[5*i + 2 + k]] += j->count[i];
            j->corners[j->facet[5*i + 2 + k]] += j->count[i];
        }
}
/* Points on the line from a to b, not at its ends, each place once, in the order of the line; out
   may be null. */
static int demi_join_between(const demi_join *j, int32_t a, int32_t b, int32_t *out) {
    const double *p = j->x + 3*a, *q = j->x + 3*b;
    const double size2 = demi_far2(p, q), ends = DEMI_MIN(j->near_by[a], j->near_by[b]);
    demi_search_line line;
    int32_t at;
    int i, n = 0;
    demi_tree_line(&line, &j->tree, p, q, ends);
    while ((at = demi_tree_next(&line)) >= 0) {
        const double *y = j->x + 3*at;
        const double most = DEMI_MIN(ends, j->near_by[at]);
        double t = 0, off2 = 0;
        int k;
        if (j->same[at] != at || at == a || at == b || !(j->corners[at] > 0)) continue;
        for (k = 0; k < 3; k++) t += (y[k] - p[k])*(q[k] - p[k]);
        t /= size2;
        if (!(t > 0 && t < 1)) continue;
        for (k = 0; k < 3; k++) {
            const double d = y[k] - p[k] - t*(q[k] - p[k]);
            off2 += d*d;
        }
        if (!(off2 <= most*most)) continue;
        n++;
        if (!out) continue;
        for (i = n - 1; i > 0 && demi_far2(p, j->x + 3*out[i - 1]) > t*t*size2; i--)
            out[i] = out[i - 1];
        out[i] = at;
    }
    return n;
}
/* Sides of triangles, cut where corners of others lie on them. 0 when memory ran out. */
static int demi_join_cut(dem_world *w, demi_join *j) {
    int32_t *between = 0;
    size_t most = 0, room = 0;
    int i, k, end, cuts, n = 0, pass;
    for (i = 0; i < j->facets; i++)
        for (k = 0; k < 3; k++)
            j->side[j->sides++] = demi_side_of(j->facet[5*i + 2 + k], j->facet[5*i + 2 + (k + 1)%3],
                                               i, k);
    qsort(j->side, (size_t)j->sides, sizeof *j->side, demi_side_compare);
    for (pass = 0; pass < 2; pass++) {          /* how many; then make them */
        for (i = 0; i < j->sides; i = end) {
            const demi_side *s = j->side + i;
            for (end = i; end < j->sides && j->side[end].lo == s->lo && j->side[end].hi == s->hi;)
                end++;
            cuts = demi_join_between(j, s->lo, s->hi, between);
            most = DEMI_MAX(most, (size_t)cuts);
            room += pass ? 0 : (size_t)(end - i)*((size_t)cuts + 1);
            j->cut_room += pass || !cuts ? 0 : (size_t)(end - i)*((size_t)cuts + 1);
            for (; pass && s < j->side + end; s++) {
                for (k = 0; k <= cuts; k++)
                    j->piece[n++] = demi_side_of(k ? between[k - 1] : s->lo, k < cuts ? between[k]
                                                 : s->hi, s->facet, s->side + (cuts ? 3 : 0));
                for (k = 0; k < cuts; k++) j->faces[between[k]] += j->count[s->facet];
            }
        }
        if (pass) break;
        if (room > INT_MAX/8) return 0;
        j->piece = (demi_side *)demi_alloc(w, room, sizeof *j->piece);
        between = (int32_t *)demi_alloc(w, most, sizeof *between);
        j->cut = (int32_t *)demi_alloc(w, j->cut_room*6, sizeof *j->cut);
        j->cut_weight = (double *)demi_alloc(w, j->cut_room, sizeof *j->cut_weight);
        if ((room && !j->piece) || (most && !between) ||
            (j->cut_room && (!j->cut || !j->cut_weight))) break;
    }
    j->sides = n;
    if (pass == 1 && n) qsort(j->piece, (size_t)n, sizeof *j->piece, demi_side_compare);
    demi_free(w, between);
    return pass == 1;
}
/* One wall's part, `more`, of a place where sides first .. end - 1 of the join lie: at an edge of
   its own, or at the first of its cuts; the other cuts remember where it is. */
static void demi_join_edge(dem_world *w, demi_join *j, int first, int end, int id, double more) {
    demi_wall *wall = &w->walls[id];
    int k, whole = -1, number = 0;
    for (k = first; k < end && whole < 0; k++) {
        const int32_t *f = j->facet + 5*j->piece[k].facet;
        if (f[0] == id && j->piece[k].side < 3)
            whole = wall->edges[3*f[1] + j->piece[k].side];
    }
    if (whole >= 0) {
        number = wall->element_count + whole;
        wall->weight[number] = (dem_real)more;
    } else number = wall->element_count + wall->edge_count + wall->vertex_count + wall->cut_count;
    for (k = first; k < end; k++) {
        const demi_side *s = j->piece + k;
        const int32_t *f = j->facet + 5*s->facet;
        int32_t *c;
        if (f[0] != id || s->side < 3) continue;
        c = j->cut + 6*j->cuts;
        c[0] = id; c[1] = f[1]; c[2] = s->lo; c[3] = s->hi; c[4] = number; c[5] = s->side - 3;
        j->cut_weight[j->cuts++] = whole < 0 ? more : 0;
        wall->cut_count++;
        whole = 0;                              /* the first cut has it */
    }
}
/* What edges count; each wall gets its share of it. */
static void demi_join_edges(dem_world *w, demi_join *j) {
    int i, k, end, other;
    for (i = 0; i < j->sides; i = end) {
        const demi_side *s = j->piece + i;
        double all = 0;
        for (end = i; end < j->sides && j->piece[end].lo == s->lo && j->piece[end].hi == s->hi;)
            all += j->count[j->piece[end++].facet];
        j->edges[s->lo] += all > 0 ? 1 - all : 0;
        j->edges[s->hi] += all > 0 ? 1 - all : 0;
        for (k = i; k < end; k++) {             /* walls one by one, at the first side of each */
            const int id = j->facet[5*j->piece[k].facet];
            double mine = 0;
            int first = k;
            if (id < 0) continue;               /* an image */
            for (other = i; other < end; other++) {
                if (j->facet[5*j->piece[other].facet] != id) continue;
                first = DEMI_MIN(first, other);
                mine += j->count[j->piece[other].facet];
            }
            if (first == k)
                demi_join_edge(w, j, i, end, id, all > 0 ? mine*(1 - all)/all : 0);
        }
    }
}
/* Corners of profiles that lie on other segments are corners of those as well. */
static int demi_join_profiles(dem_world *w, demi_join *j) {
    int32_t *between = (int32_t *)demi_alloc(w, (size_t)j->points, sizeof *between);
    int i, k;
    if (!between) return 0;
    for (i = 0; i < j->facets; i++) {
        const int n = demi_join_between(j, j->facet[5*i + 2], j->facet[5*i + 3], between);
        for (k = 0; k < n; k++) j->faces[between[k]] += j->count[i];
    }
    demi_free(w, between);
    return 1;
}
/* What corners and faces count. */
static void demi_join_corners(dem_world *w, demi_join *j) {
    int f, end, g, k;
    for (f = 0; f < j->facets; f = end) {       /* one wall after the other */
        const int id = j->facet[5*f];
        demi_wall *wall = &w->walls[id < 0 ? 0 : id];
        dem_real *corner;
        if (id < 0) return;                     /* images get nothing */
        corner = wall->weight + wall->element_count + wall->edge_count;
        memset(j->own, 0, (size_t)j->points*sizeof *j->own);
        for (end = f; end < j->facets && j->facet[5*end] == id; end++) {
            wall->weight[j->facet[5*end + 1]] = (dem_real)j->count[end];
            for (k = 0; k < j->per; k++) j->own[j->facet[5*end + 2 + k]] += j->count[end];
        }
        for (g = f; g < end; g++) {
            const int element = j->facet[5*g + 1];
            for (k = 0; k < j->per; k++) {
                const int32_t at = j->facet[5*g + 2 + k];
                if (!(wall->owns[element] >> (3 + k) & 1) || !(j->own[at] > 0)) continue;
                corner[wall->corners[j->per*element + k]] =
                    (dem_real)((1 - j->faces[at] - j->edges[at])*j->own[at]/j->corners[at]);
                j->own[at] = 0;
            }
        }
    }
}
static dem_vec3 demi_join_local(const demi_join *j, const demi_wall *wall, int32_t point) {
    const double *x = j->x + 3*point;
    return demi_unrotate(wall->home.rotation, demi_sub(demi_v((dem_real)x[0], (dem_real)x[1],
                                                            (dem_real)x[2]), wall->home.position));
}
/* Hands the cuts over to their walls, by element. 0 when memory ran out. */
static int demi_join_hand(dem_world *w, const demi_join *j, int group) {
    int32_t *own = j->mark;                     /* by point: number of the wall's corner there */
    int i, k, e, first = 0, passed = 0;
    for (i = group; i < w->wall_count; i++) {
        demi_wall *wall = &w->walls[i];
        const size_t n = (size_t)wall->element_count + 1;
        if (!demi_join_member(w, i, group, j->per)) continue;
        first = passed;
        passed += wall->vertex_count;
        wall->number_count += wall->cut_count;
        if (!wall->cut_count) continue;
        wall->cut_start = (int32_t *)demi_hold(w, DEMI_SCENE, n, sizeof(int32_t));
        wall->cuts = (demi_cut *)demi_hold(w, DEMI_SCENE, (size_t)wall->cut_count,
                                           sizeof(demi_cut));
        if (!wall->cut_start || !wall->cuts) return 0;
        for (k = 0; k < j->points; k++) own[k] = -1;
        for (k = 0; k < wall->vertex_count; k++) {
            const int32_t at = j->same[first + k];
            if (own[at] < 0) own[at] = wall->element_count + wall->edge_count + k;
        }
        for (k = 0; k < j->cuts; k++) if (j->cut[6*k] == i) wall->cut_start[j->cut[6*k + 1] + 1]++;
        for (k = 0; k < wall->element_count; k++) wall->cut_start[k + 1] += wall->cut_start[k];
        for (k = j->cuts - 1; k >= 0; k--) {    /* from the back: starts end where they were */
            const int32_t *c = j->cut + 6*k;
            demi_cut *to;
            if (c[0] != i) continue;
            to = wall->cuts + --wall->cut_start[c[1] + 1];
            to->a = demi_join_local(j, wall, c[2]);
            to->b = demi_join_local(j, wall, c[3]);
            to->number = c[4];
            to->side = c[5];
            for (e = 0; e < 2; e++)             /* corners of other walls: beyond its own numbers */
                to->end[e] = own[c[2 + e]] >= 0 ? own[c[2 + e]]
                    : wall->number_count + c[2 + e];
            to->weight = (dem_real)j->cut_weight[k];
        }
        for (k = 0; k < wall->element_count; k++) wall->cut_start[k] = wall->cut_start[k + 1];
        wall->cut_start[wall->element_count] = wall->cut_count;
        wall->number_count += j->points;
    }
    return 1;
}
/* Without pieces: facets have no neighbours but those that share corners. */
static void demi_facets_drop_cuts(dem_world *w, demi_wall *wall) {
    demi_free(w, wall->cut_start);
    demi_free(w, wall->cuts);
    wall->cut_start = 0;
    wall->cuts = 0;
    wall->cut_count = 0;
}
/* Which walls of a group share nothing with others, nor with images of their own. */
static void demi_join_lone(dem_world *w, int group, int per) {
    int i, members = 0;
    for (i = group; i < w->wall_count; i++) members += demi_join_member(w, i, group, per);
    for (i = group; i < w->wall_count; i++) {
        const int *repeats = w->walls[i].repeats;
        if (demi_join_member(w, i, group, per))
            w->walls[i].lone = members == 1 && !repeats[0] && !repeats[1] && !repeats[2];
    }
}
/* Groups the walls and weighs their facets anew. 0 when memory ran out; the next call tries again.
   */
static int demi_facets_weigh(dem_world *w) {
    int i, k, per, ok = 1;
    demi_walls_repeat(w);
    for (i = 0; i < w->wall_count; i++) {
        demi_wall *wall = &w->walls[i];
        for (k = 0; k < i; k++)
            if (w->walls[k].kind != DEMI_WALL_NONE && demi_walls_together(&w->walls[k], wall))
                break;
        wall->group = k;
        if (!demi_faceted(wall)) continue;
        demi_facets_drop_cuts(w, wall);
        wall->number_count = wall->element_count + wall->edge_count + wall->vertex_count;
        memset(wall->weight, 0, ((size_t)wall->element_count + (size_t)wall->edge_count +
                                 (size_t)wall->vertex_count)*sizeof(dem_real));
    }
    for (i = 0; i < w->wall_count && ok; i++)
        for (per = 2; per <= 3 && ok; per++) {
            demi_join j;
            if (w->walls[i].kind == DEMI_WALL_NONE || w->walls[i].group != i) continue;
            for (k = i; k < w->wall_count && !demi_join_member(w, k, i, per);) k++;
            if (k == w->wall_count) continue;
            demi_join_lone(w, i, per);
            ok = demi_join_begin(w, &j, i, per);
            if (ok) demi_join_double(&j);
            if (ok) ok = per == 3 ? demi_join_cut(w, &j) : demi_join_profiles(w, &j);
            if (ok && per == 3) demi_join_edges(w, &j);
            if (ok) demi_join_corners(w, &j);
            if (ok) ok = demi_join_hand(w, &j, i);
            demi_join_free(w, &j);
        }
    w->facets_valid = ok;
    return ok;
}

/* ---------------------------------------------------------------------------------------------
   >>walls
   A wall is rigid: elements in a frame of its own and a motion that says where that frame is. Walls
   of many elements keep a grid of them in their own frame, so that a grain finds its neighbours at
   a cost that does not depend on their number. Planes and cylinders are one element each, without
   end. Kinds are rows: DEMI_WALLS in >>memory.
   --------------------------------------------------------------------------------------------- */
static void demi_pose_identity(dem_pose *p) {
    memset(p, 0, sizeof *p);
    p->rotation[0] = p->rotation[4] = p->rotation[8] = 1;
}

/* Where the wall is at a time. Rotating: exact rotation from the pose it started with, so that no
   error builds up. Velocities are exact derivatives. */
static void demi_wall_pose_at(const demi_wall *wall, double time, dem_pose *pose) {
    const dem_motion *m = &wall->motion;
    const double t = time - m->start;
    *pose = wall->home;
    pose->velocity = pose->spin = demi_v(0, 0, 0);
    switch (m->kind) {
    case DEM_MOTION_FIXED: break;
    case DEM_MOTION_TRANSLATING:
        if (t <= 0) break;
        pose->position = demi_add(pose->position, demi_scale(m->velocity, (dem_real)t));
        pose->velocity = m->velocity;
        break;
    case DEM_MOTION_ROTATING: {
        const dem_vec3 axis = demi_unit(m->axis), arm = demi_sub(wall->home.position, m->point);
        double turn[9];
        dem_real T[9];
        int i, j;
        if (t <= 0) break;
        demi_rotation(turn, (double)axis.x, (double)axis.y, (double)axis.z,
                      fmod((double)m->speed*t, 2*DEMI_PI));
        for (i = 0; i < 9; i++) T[i] = (dem_real)turn[i];
        for (i = 0; i < 3; i++)
            for (j = 0; j < 3; j++)
                pose->rotation[3*i + j] = (dem_real)(turn[3*i]*(double)wall->home.rotation[j] +
                    turn[3*i + 1]*(double)wall->home.rotation[3 + j] +
                    turn[3*i + 2]*(double)wall->home.rotation[6 + j]);
        pose->position = demi_add(m->point, demi_rotate(T, arm));
        pose->spin = demi_scale(axis, m->speed);
        pose->velocity = demi_cross(pose->spin, demi_sub(pose->position, m->point));
        break;
    }
    case DEM_MOTION_OSCILLATING: {
        const dem_vec3 way = demi_unit(m->velocity);
        const double w = 2*DEMI_PI*(double)m->frequency, phase = w*t + (double)m->phase;
        const dem_real way_out = (dem_real)((double)m->amplitude*sin(phase));
        pose->position = demi_add(pose->position, demi_scale(way, way_out));
        pose->velocity = demi_scale(way, (dem_real)((double)m->amplitude*w*cos(phase)));
        break;
    }
    case DEM_MOTION_USER: m->function(time, pose, m->user); break;
    }
}

static int demi_pose_finite(const dem_pose *p) {
    int i, ok = demi_finite3(p->position) && demi_finite3(p->velocity) && demi_finite3(p->spin);
    for (i = 0; i < 9; i++) ok = ok && demi_finite(p->rotation[i]);
    return ok;
}

/* An upper bound of the speed of the wall's surface (m/s); 0 when its motion leaves the surface in
   place. */
static double demi_wall_speed(const demi_wall *wall) {
    const dem_pose *p = &wall->pose;
    if (wall->kind == DEMI_WALL_NONE || wall->symmetric) return 0;
    if (wall->extent < 0 && demi_length(p->spin) > 0) return -1;   /* endless: no bound, look again
                                                                     every step */
    if (wall->extent < 0) return (double)demi_length(p->velocity);
    return (double)demi_length(p->velocity) + (double)demi_length(p->spin)*(double)wall->extent;
}

/* The arrays a wall owns: where their pointers stand. What is freed, and copied into slabs. */
#define DEMI_WALL_ARRAYS(wall) {&(wall)->vertices, &(wall)->corners, &(wall)->edges, \
    &(wall)->weight, &(wall)->owns, &(wall)->planes, &(wall)->cut_start, &(wall)->cuts, \
    &(wall)->cell_start, &(wall)->cell_items}
/* Its arrays, by the one list of them; what is left is a wall that was removed. */
static void demi_wall_free(dem_world *w, demi_wall *wall) {
    void *places[] = DEMI_WALL_ARRAYS(wall), *data;
    size_t k;
    for (k = 0; k < sizeof places/sizeof *places; k++) {
        memcpy(&data, places[k], sizeof data);
        demi_free(w, data);
    }
    memset(wall, 0, sizeof *wall);
}
/* Arrays of its own instead of those it shares with another wall. 0 when memory ran out: it has
   none then. */
static int demi_wall_own(dem_world *w, demi_wall *wall) {
    void *places[] = DEMI_WALL_ARRAYS(wall), *data, *copy;
    size_t k;
    int ok = 1;
    for (k = 0; k < sizeof places/sizeof *places; k++) {
        memcpy(&data, places[k], sizeof data);
        copy = data ? demi_hold(w, DEMI_SCENE, demi_room(data, 1), 1) : 0;
        ok = ok && !copy == !data;
        if (copy) memcpy(copy, data, demi_room(data, 1));
        memcpy(places[k], &copy, sizeof copy);
    }
    if (!ok) demi_wall_free(w, wall);
    return ok;
}

/* Number of corners an element of this wall has; their coordinates. */
static int demi_wall_corners(const demi_wall *wall, int element, dem_vec3 *out) {
    const int n = demi_wall_per(wall);
    int k;
    for (k = 0; k < n; k++)
        out[k] = demi_at(wall->vertices + 3*(wall->corners ? wall->corners[n*element + k]
                                             : element));
    return n;
}

/* Cells of the element grid that a box touches. */
static void demi_wall_cells(const demi_wall *wall, dem_vec3 lo, dem_vec3 hi, int *first,
                            int *last) {
    double a[3], b[3], o[3];
    int k;
    a[0] = (double)lo.x; a[1] = (double)lo.y; a[2] = (double)lo.z;
    b[0] = (double)hi.x; b[1] = (double)hi.y; b[2] = (double)hi.z;
    o[0] = (double)wall->box.lo.x; o[1] = (double)wall->box.lo.y; o[2] = (double)wall->box.lo.z;
    for (k = 0; k < 3; k++) {
        const double f = floor((a[k] - o[k])/(double)wall->cell);
        const double l = floor((b[k] - o[k])/(double)wall->cell);
        first[k] = f < 0 ? 0 : f > wall->cells[k] ? wall->cells[k] : (int)f;
        last[k] = l >= wall->cells[k] ? wall->cells[k] - 1 : l < -1 ? -1 : (int)l;
    }
}

/* Box of an element, with what grains of a wall stand out. */
static dem_box demi_wall_element_box(const demi_wall *wall, int element) {
    const dem_real pad = demi_wall_is(wall, DEMI_BALLS) ? wall->radius : 0;
    dem_vec3 c[3];
    dem_box box;
    int k, n;
    c[0] = demi_v(0, 0, 0);
    n = demi_wall_corners(wall, element, c);
    box.lo = box.hi = c[0];
    for (k = 1; k < n; k++) {
        box.lo = demi_v(DEMI_MIN(box.lo.x, c[k].x), DEMI_MIN(box.lo.y, c[k].y),
                        DEMI_MIN(box.lo.z, c[k].z));
        box.hi = demi_v(DEMI_MAX(box.hi.x, c[k].x), DEMI_MAX(box.hi.y, c[k].y),
                        DEMI_MAX(box.hi.z, c[k].z));
    }
    box.lo = demi_sub(box.lo, demi_v(pad, pad, pad));
    box.hi = demi_add(box.hi, demi_v(pad, pad, pad));
    return box;
}
/* Box of all, and how far from the frame's origin they go. */
static void demi_wall_bounds(demi_wall *wall) {
    const dem_real pad = demi_wall_is(wall, DEMI_BALLS) ? wall->radius : 0;
    dem_real extent = 0;
    int i;
    wall->box = demi_wall_element_box(wall, 0);
    for (i = 1; i < wall->element_count; i++) {
        const dem_box b = demi_wall_element_box(wall, i);
        wall->box.lo = demi_v(DEMI_MIN(wall->box.lo.x, b.lo.x), DEMI_MIN(wall->box.lo.y, b.lo.y),
                              DEMI_MIN(wall->box.lo.z, b.lo.z));
        wall->box.hi = demi_v(DEMI_MAX(wall->box.hi.x, b.hi.x), DEMI_MAX(wall->box.hi.y, b.hi.y),
                              DEMI_MAX(wall->box.hi.z, b.hi.z));
    }
    for (i = 0; i < wall->vertex_count; i++)
        extent = DEMI_MAX(extent, demi_length(demi_at(wall->vertices + 3*i)) + pad);
    wall->extent = extent;
}
/* Size of the cells: the mean element, so that each is in few, but finer where elements are long
   and thin; coarser until neither cells nor entries are too many. */
static void demi_wall_cells_choose(demi_wall *wall) {
    const dem_vec3 size = demi_sub(wall->box.hi, wall->box.lo);
    const double volume = (double)size.x*(double)size.y*(double)size.z, n = wall->element_count;
    double extent = 0, mean, fine, entries;
    int i, k, f[3], l[3];
    for (i = 0; i < wall->element_count; i++) {
        dem_vec3 c[3];
        const int corners = demi_wall_corners(wall, i, c);
        for (k = 1; k < corners; k++)
            extent += (double)demi_length(demi_sub(c[k], c[0]))/(corners - 1);
        if (corners == 1) extent += 2*(double)wall->radius;
    }
    mean = extent/n;
    fine = volume > 0 ? pow(volume/(16*n), 1.0/3) : mean;
    wall->cell = (dem_real)DEMI_MAX(DEMI_MIN(mean, fine), 1e-6*(double)demi_length(size));
    for (;; wall->cell *= DEM_R(1.26)) {
        wall->cells[0] = (int)DEMI_MIN(size.x/wall->cell, DEM_R(1e6)) + 1;
        wall->cells[1] = (int)DEMI_MIN(size.y/wall->cell, DEM_R(1e6)) + 1;
        wall->cells[2] = (int)DEMI_MIN(size.z/wall->cell, DEM_R(1e6)) + 1;
        if ((double)wall->cells[0]*wall->cells[1]*wall->cells[2] > 32*n + 64) continue;
        for (i = 0, entries = 0; i < wall->element_count; i++) {
            const dem_box b = demi_wall_element_box(wall, i);
            demi_wall_cells(wall, b.lo, b.hi, f, l);
            entries += (double)(l[0] - f[0] + 1)*(l[1] - f[1] + 1)*(l[2] - f[2] + 1);
        }
        if (entries <= 48*n + 64) return;
    }
}
/* The grid of a wall's elements. 0 when memory ran out. */
static int demi_wall_index(dem_world *w, demi_wall *wall) {
    int i, n, pass, x, y, z, f[3], l[3];
    if (wall->element_count <= 4) return 1;     /* a handful: just look at all */
    demi_wall_cells_choose(wall);
    n = wall->cells[0]*wall->cells[1]*wall->cells[2];
    wall->cell_start = (int32_t *)demi_hold(w, DEMI_SCENE, (size_t)n + 1, sizeof(int32_t));
    if (!wall->cell_start) return 0;
    for (pass = 0; pass < 2; pass++) {          /* count, then fill from the back */
        for (i = wall->element_count - 1; i >= 0; i--) {
            const dem_box b = demi_wall_element_box(wall, i);
            demi_wall_cells(wall, b.lo, b.hi, f, l);
            for (z = f[2]; z <= l[2]; z++)
                for (y = f[1]; y <= l[1]; y++)
                    for (x = f[0]; x <= l[0]; x++) {
                        int32_t *slot = &wall->cell_start[x +
                                                          wall->cells[0]*(y + wall->cells[1]*z)];
                        if (pass == 0) ++*slot; else wall->cell_items[--*slot] = i;
                    }
        }
        if (pass == 0) {
            for (i = 1; i <= n; i++) wall->cell_start[i] += wall->cell_start[i - 1];
            wall->cell_item_count = wall->cell_start[n];
            wall->cell_items = (int32_t *)demi_hold(w, DEMI_SCENE, (size_t)wall->cell_item_count,
                                                     sizeof(int32_t));
            if (!wall->cell_items) return 0;
        }
    }
    return 1;
}

/* Takes over a prepared wall (its arrays included) or frees it. */
static dem_wall demi_wall_adopt(dem_world *w, const char *call, demi_wall *wall) {
    dem_wall id;
    int i;
    id.id = 0;
    wall->pose = wall->mid = wall->first = wall->home;
    for (i = 0; i < w->bodies.count && w->bodies.shaped; i++) {
        const int part = demi_shape_kind(demi_shape_of(w, i));
        if (demi_touch_known(wall->kind, part)) continue;
        demi_strangers(w, call, w->wall_count, wall->kind, (int)w->bodies.slot[i], part);
        demi_wall_free(w, wall);
        return id;
    }
    if (!demi_list_drop(w)) { demi_wall_free(w, wall); demi_no_memory(w, call); return id; }
    if (!DEMI_GROW(w, w->walls, (size_t)w->wall_count + 1)) {
        demi_wall_free(w, wall);
        demi_no_memory(w, call);
        return id;
    }
    w->walls[w->wall_count++] = *wall;
    w->facets_valid = 0;
    demi_built(w, call);
    demi_scene_changed(w);
    id.id = w->wall_count;
    return id;
}

/* What all kinds of walls have in common. 0 with a sentence when there is no such material. */
static int demi_wall_begin(dem_world *w, const char *call, dem_material material, int kind,
                           demi_wall *wall) {
    memset(wall, 0, sizeof *wall);
    demi_pose_identity(&wall->home);
    wall->kind = kind;
    wall->share = 1;
    wall->symmetric = 1;                        /* until it moves */
    return demi_material_index(w, call, material, &wall->material) == DEM_OK;
}

DEM_API dem_wall dem_plane_add(dem_world *w, dem_material material, dem_vec3 point,
                               dem_vec3 normal) {
    if (demi_null(w, "dem_plane_add", w, "world")) return demi_no_wall;
    demi_wall wall;
    dem_wall none;
    none.id = 0;
    if (!demi_wall_begin(w, "dem_plane_add", material, DEMI_WALL_PLANE, &wall)) return none;
    if (!demi_finite3(point) || !demi_finite3(normal) || !(demi_size(normal) > 0)) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "dem_plane_add: normal is (%g, %g, %g), must be finite "
                  "and not zero, point "
                  "finite", (double)normal.x, (double)normal.y, (double)normal.z);
        return none;
    }
    wall.element_count = 1;
    wall.home.position = point;
    wall.motion.point = point;
    wall.motion.axis = demi_unit(normal);
    demi_frame_of(wall.home.rotation, demi_unit(normal));
    wall.extent = -1;
    return demi_wall_adopt(w, "dem_plane_add", &wall);
}

DEM_API dem_wall dem_cylinder_add(dem_world *w, dem_material material, dem_vec3 point,
                                  dem_vec3 axis,
                                  dem_real radius, int inside) {
    if (demi_null(w, "dem_cylinder_add", w, "world")) return demi_no_wall;
    demi_wall wall;
    dem_wall none;
    none.id = 0;
    if (!demi_wall_begin(w, "dem_cylinder_add", material, DEMI_WALL_CYLINDER, &wall)) return none;
    if (!demi_finite3(point) || !demi_finite3(axis) || !(demi_dot(axis, axis) > 0) ||
        !(radius > 0) || !demi_finite(radius)) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "dem_cylinder_add: radius is %g m and axis (%g, %g, %g), "
                  "must be > 0 and not "
                  "zero", (double)radius, (double)axis.x, (double)axis.y, (double)axis.z);
        return none;
    }
    wall.element_count = 1;
    wall.radius = radius;
    wall.inside = inside != 0;
    wall.home.position = point;
    wall.motion.point = point;
    wall.motion.axis = demi_unit(axis);
    demi_frame_of(wall.home.rotation, demi_unit(axis));
    wall.extent = -1;
    return demi_wall_adopt(w, "dem_cylinder_add", &wall);
}

/* Copies vertices (dimension `per_vertex`) and corners into a wall. 0 with a sentence when they are
   bad. */
static int demi_wall_load(dem_world *w, const char *call, demi_wall *wall, int vertices,
                          const dem_real *xyz,
                          int per_vertex, int elements, const int32_t *corners, int per_element) {
    int i, k;
    if (vertices < 1 || elements < 1 || vertices > INT_MAX/8 || elements > INT_MAX/8 || !xyz ||
        (per_element && !corners)) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "%s: %d vertices and %d elements, must be at least one of "
                  "each, at most %d, with pointers to them; was the file read?", call, vertices,
                  elements, INT_MAX/8);
        return 0;
    }
    for (i = 0; i < vertices*per_vertex; i++)
        if (!demi_finite(xyz[i]) || fabs((double)xyz[i]) > DEMI_FARTHEST) {
            demi_fail(w, DEM_ERROR_ARGUMENT, "%s: a coordinate of vertex %d is %g m, must be "
                      "finite and between -%g and %g; was the file read whole, in metres?", call,
                      i/per_vertex, (double)xyz[i], DEMI_FARTHEST, DEMI_FARTHEST);
            return 0;
        }
    for (i = 0; i < elements*per_element; i++)
        if (corners[i] < 0 || corners[i] >= vertices) {
            demi_fail(w, DEM_ERROR_ARGUMENT, "%s: element %d names vertex %d, must be 0 to %d; are "
                      "they counted from 1?",
                      call, i/per_element, (int)corners[i], vertices - 1);
            return 0;
        }
    wall->vertex_count = vertices;
    wall->element_count = elements;
    wall->vertices = (dem_real *)demi_hold(w, DEMI_SCENE, (size_t)vertices*3, sizeof(dem_real));
    if (per_element) wall->corners = (int32_t *)demi_hold(w, DEMI_SCENE,
                                                           (size_t)elements*(size_t)per_element,
                                                           sizeof(int32_t));
    if (!wall->vertices || (per_element && !wall->corners)) {
        demi_wall_free(w, wall);
        demi_no_memory(w, call);
        return 0;
    }
    for (i = 0; i < vertices; i++)
        for (k = 0; k < per_vertex; k++) wall->vertices[3*i + k] = xyz[per_vertex*i + k];
    if (per_element) memcpy(wall->corners, corners,
                            (size_t)elements*(size_t)per_element*sizeof(int32_t));
    if (per_element && !demi_facets_begin(w, wall)) {
        demi_wall_free(w, wall);
        demi_no_memory(w, call);
        return 0;
    }
    demi_wall_bounds(wall);
    if (per_element && (!demi_facets_any(wall) ||
                        !(demi_size(demi_sub(wall->box.hi, wall->box.lo)) > DEMI_LEAST))) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "%s: of %d elements none has a size: corners in one "
                  "place, triangles without height, or all within %g m; were the coordinates "
                  "lost, or in another unit?", call, elements, DEMI_LEAST);
        demi_wall_free(w, wall);
        return 0;
    }
    if (!demi_wall_index(w, wall)) {
        demi_wall_free(w, wall);
        demi_no_memory(w, call);
        return 0;
    }
    return 1;
}

DEM_API dem_wall dem_profile_add(dem_world *w, dem_material material, const dem_profile *profile,
                                 dem_edge_rule rule) {
    if (demi_null(w, "dem_profile_add", profile, "profile")) return demi_no_wall;
    demi_wall wall;
    dem_wall none;
    none.id = 0;
    if (!demi_wall_begin(w, "dem_profile_add", material, rule == DEM_EDGE_FRACTION
                         ? DEMI_WALL_SEGMENTS : DEMI_WALL_PROFILE, &wall)) return none;
    if (rule < DEM_EDGE_RESOLVED || rule > DEM_EDGE_FRACTION) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "dem_profile_add: rule is %d, must be DEM_EDGE_RESOLVED "
                  "(0) to DEM_EDGE_FRACTION (%d); was it set?", (int)rule, (int)DEM_EDGE_FRACTION);
        return none;
    }
    wall.rule = rule;
    if (!demi_wall_load(w, "dem_profile_add", &wall, profile->vertex_count, profile->vertices, 2,
                        profile->segment_count, profile->segments, 2)) return none;
    wall.motion.axis = demi_v(0, 0, 1);
    return demi_wall_adopt(w, "dem_profile_add", &wall);
}

DEM_API dem_wall dem_mesh_add(dem_world *w, dem_material material, const dem_mesh *mesh) {
    if (demi_null(w, "dem_mesh_add", mesh, "mesh")) return demi_no_wall;
    demi_wall wall;
    dem_wall none;
    none.id = 0;
    if (!demi_wall_begin(w, "dem_mesh_add", material, DEMI_WALL_MESH, &wall) ||
        !demi_wall_load(w, "dem_mesh_add", &wall, mesh->vertex_count, mesh->vertices, 3,
                        mesh->triangle_count, mesh->triangles, 3)) return none;
    wall.motion.axis = demi_v(0, 0, 1);
    return demi_wall_adopt(w, "dem_mesh_add", &wall);
}

DEM_API dem_wall dem_grains_wall_add(dem_world *w, dem_material material, int count,
                                     const dem_real *positions,
                                     dem_real radius, dem_real share) {
    if (demi_null(w, "dem_grains_wall_add", w, "world")) return demi_no_wall;
    demi_wall wall;
    dem_wall none;
    none.id = 0;
    if (!demi_wall_begin(w, "dem_grains_wall_add", material, DEMI_WALL_GRAINS, &wall)) return none;
    if (!(radius > 0) || !demi_finite(radius) || !(share > 0) || !(share <= 1)) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "dem_grains_wall_add: radius is %g m and share %g, must "
                  "be > 0 and 0 < share "
                  "<= 1", (double)radius, (double)share);
        return none;
    }
    wall.radius = radius;
    wall.share = share;
    wall.motion.axis = demi_v(0, 0, 1);
    if (!demi_wall_load(w, "dem_grains_wall_add", &wall, count, positions, 3, count, 0,
                        0)) return none;
    return demi_wall_adopt(w, "dem_grains_wall_add", &wall);
}

DEM_API dem_wall dem_sieve_add(dem_world *w, dem_material material, const dem_sieve_desc *d) {
    if (demi_null(w, "dem_sieve_add", d, "desc")) return demi_no_wall;
    demi_wall wall;
    dem_wall none;
    const char *bad = 0, *limit = "";
    dem_real value = 0;
    dem_vec3 n = d->normal, t = d->along;
    dem_real *R = wall.home.rotation;
    const int plate = d->kind == DEM_SIEVE_SQUARE || d->kind == DEM_SIEVE_ROUND ||
                      d->kind == DEM_SIEVE_SLOTS;
    none.id = 0;
    if (!demi_wall_begin(w, "dem_sieve_add", material, DEMI_WALL_SIEVE, &wall)) return none;
#define DEMI_BAD(field, good, text) \
    if (!bad && (!demi_finite((dem_real)d->field) || !(good))) { \
        bad = #field; value = (dem_real)d->field; limit = text; \
    }
    DEMI_BAD(kind, (int)d->kind > 0 && d->kind <= DEM_SIEVE_REDUCED, "a DEM_SIEVE_ value")
    DEMI_BAD(aperture, d->aperture > 0, "> 0 m (required)")
    DEMI_BAD(bar, d->bar > 0, "> 0 m (required)")
    DEMI_BAD(length, DEMI_ABS(d->length) <= 0 || (d->kind == DEM_SIEVE_SLOTS &&
             d->length >= d->aperture), "0, or of slots at least the aperture, in m")
    DEMI_BAD(thickness, DEMI_ABS(d->thickness) <= 0 || (plate && d->thickness > 0),
             ">= 0 m, and 0 but for plates")
    DEMI_BAD(lift, DEMI_ABS(d->lift) <= 0 || (d->kind == DEM_SIEVE_WIRES && d->lift > 0),
             ">= 0 m, and 0 but for a weave of wires")
    DEMI_BAD(radius, d->radius >= 0, ">= 0 m")
    DEMI_BAD(staggered, !d->staggered || d->kind == DEM_SIEVE_ROUND, "0 but for round holes")
    DEMI_BAD(model, !d->model || (d->kind == DEM_SIEVE_REDUCED && d->model > 0 && d->model <= 2),
             "0, or of reduced holes 1 or 2")
    DEMI_BAD(clearance, DEMI_ABS(d->clearance) <= 0 || (d->kind == DEM_SIEVE_REDUCED &&
             d->clearance > 0 && d->clearance <= 1), "0, or of reduced holes up to 1")
#undef DEMI_BAD
    if (bad) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "dem_sieve_add: %s is %g, must be %s; start from "
                  "DEM_SIEVE_DESC and set what differs", bad, (double)value, limit);
        return none;
    }
    if (!demi_finite3(d->point) || !demi_finite3(n) || !demi_finite3(t)) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "dem_sieve_add: point, normal or along is not finite; "
                  "check how it was computed");
        return none;
    }
    n = demi_size(n) > 0 ? demi_unit(n) : demi_v(0, 0, 1);
    if (demi_size(t) > 0) t = demi_unit(t);
    t = demi_sub(t, demi_scale(n, demi_dot(t, n)));
    if (!(demi_dot(t, t) > DEM_R(1e-6))) {      /* not said, or across the sieve: x, else y */
        const dem_vec3 x = DEMI_ABS(n.x) < DEM_R(0.9) ? demi_v(1, 0, 0) : demi_v(0, 1, 0);
        t = demi_sub(x, demi_scale(n, demi_dot(x, n)));
    }
    t = demi_unit(t);
    t = demi_unit(demi_sub(t, demi_scale(n, demi_dot(t, n))));      /* what rounding left */
    R[0] = t.x; R[3] = t.y; R[6] = t.z;
    R[2] = n.x; R[5] = n.y; R[8] = n.z;
    t = demi_cross(n, t);
    R[1] = t.x; R[4] = t.y; R[7] = t.z;
    wall.sieve = *d;
    wall.element_count = 1;
    wall.radius = d->radius;
    wall.home.position = wall.motion.point = d->point;
    wall.motion.axis = n;
    wall.extent = d->radius > 0 ? d->radius + d->thickness + d->lift + d->bar : -1;
    return demi_wall_adopt(w, "dem_sieve_add", &wall);
}

/* Index of a wall, or -1 with a sentence. */
static int demi_wall_find(dem_world *w, const char *call, dem_wall wall) {
    if (wall.id < 1 || wall.id > w->wall_count || w->walls[wall.id - 1].kind == DEMI_WALL_NONE) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "%s: wall %d does not exist, there are %d; check what "
                  "adding it returned",
                  call, (int)wall.id, w->wall_count);
        return -1;
    }
    return wall.id - 1;
}

/* 1 when turning about axis through point leaves the wall's surface where it is. */
static int demi_wall_symmetric(const demi_wall *wall) {
    const dem_motion *m = &wall->motion;
    dem_vec3 z, off;
    if (m->kind == DEM_MOTION_FIXED) return 1;
    if (m->kind != DEM_MOTION_ROTATING || wall->extent >= 0) return 0;
    z = demi_v(wall->home.rotation[2], wall->home.rotation[5], wall->home.rotation[8]);
    if (demi_length(demi_cross(z, demi_unit(m->axis))) > DEM_R(1e-6)) return 0;
    if (demi_wall_is(wall, DEMI_FLAT)) return 1;
    off = demi_sub(m->point, wall->home.position);
    return demi_length(demi_cross(z, off)) <= DEM_R(1e-6)*wall->radius;
}

DEM_API dem_result dem_wall_motion(dem_world *w, dem_wall id, const dem_motion *motion) {
    if (demi_null(w, "dem_wall_motion", motion, "motion")) return DEM_ERROR_ARGUMENT;
    const int i = demi_wall_find(w, "dem_wall_motion", id);
    demi_wall *wall;
    if (i < 0) return DEM_ERROR_ARGUMENT;
    if (motion->kind == DEM_MOTION_ROTATING && !(demi_dot(motion->axis, motion->axis) > 0))
        return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_wall_motion: axis of rotating wall %d is "
                         "zero; give a direction",
                         (int)id.id);
    if (motion->kind == DEM_MOTION_OSCILLATING && !(demi_dot(motion->velocity,
                                                             motion->velocity) > 0))
        return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_wall_motion: velocity, the direction of "
                         "oscillating wall %d, is "
                         "zero; give a direction", (int)id.id);
    if (motion->kind == DEM_MOTION_USER && !motion->function)
        return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_wall_motion: wall %d has kind DEM_MOTION_USER "
                         "and no function; "
                         "set motion.function", (int)id.id);
    if (!demi_finite3(motion->velocity) || !demi_finite3(motion->point) ||
        !demi_finite3(motion->axis) ||
        !demi_finite(motion->speed) || !demi_finite(motion->amplitude) ||
        !demi_finite(motion->frequency) ||
        !demi_finite(motion->phase) || !demi_finite_double(motion->start) ||
        (int)motion->kind < 0 || motion->kind > DEM_MOTION_USER)
        return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_wall_motion: a number in the motion of wall "
                         "%d is not finite, or "
                         "its kind %d unknown", (int)id.id, (int)motion->kind);
    if (!demi_list_drop(w)) return demi_no_memory(w, "dem_wall_motion");
    wall = &w->walls[i];
    wall->home = wall->pose;                    /* goes on from where it is */
    wall->home.velocity = wall->home.spin = demi_v(0, 0, 0);
    wall->motion = *motion;
    if (!(demi_dot(motion->axis, motion->axis) > 0)) wall->motion.axis = demi_v(0, 0, 1);
    wall->motion.start = DEMI_MAX(motion->start, w->clock.time);
    wall->symmetric = demi_wall_symmetric(wall);
    demi_wall_pose_at(wall, w->clock.time, &wall->pose);
    wall->mid = wall->pose;
    w->facets_valid = 0;
    demi_built(w, "dem_wall_motion");
    demi_scene_changed(w);
    return DEM_OK;
}

DEM_API dem_result dem_wall_pose(const dem_world *world, dem_wall id, dem_pose *pose) {
    if (demi_null(world, "dem_wall_pose", pose, "pose")) return DEM_ERROR_ARGUMENT;
    const int i = demi_wall_find((dem_world *)world, "dem_wall_pose", id);
    if (i < 0) return DEM_ERROR_ARGUMENT;
    *pose = world->walls[i].pose;
    return DEM_OK;
}

DEM_API dem_result dem_wall_remove(dem_world *w, dem_wall id) {
    if (demi_null(w, "dem_wall_remove", w, "world")) return DEM_ERROR_ARGUMENT;
    const int i = demi_wall_find(w, "dem_wall_remove", id);
    int k;
    if (i < 0) return DEM_ERROR_ARGUMENT;
    for (k = 0; k < w->outlet_count; k++)
        if (w->outlets[k].desc.frame.id == id.id)
            return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_wall_remove: outlet %d moves with wall "
                             "%d and would let nothing out any more; keep the wall", k + 1,
                             (int)id.id);
    if (!demi_list_drop(w)) return demi_no_memory(w, "dem_wall_remove");
    demi_wall_free(w, &w->walls[i]);            /* its place stays empty: ids of other walls hold */
    w->facets_valid = 0;
    demi_scene_changed(w);
    return DEM_OK;
}

DEM_API dem_result dem_wall_loads_get(const dem_world *world, dem_wall id, dem_wall_loads *loads) {
    if (demi_null(world, "dem_wall_loads_get", loads, "loads")) return DEM_ERROR_ARGUMENT;
    const int i = demi_wall_find((dem_world *)world, "dem_wall_loads_get", id);
    if (i < 0) return DEM_ERROR_ARGUMENT;
    *loads = world->walls[i].loads;
    return DEM_OK;
}
DEM_API dem_result dem_wall_loads_reset(dem_world *w, dem_wall id) {
    if (demi_null(w, "dem_wall_loads_reset", w, "world")) return DEM_ERROR_ARGUMENT;
    const int i = demi_wall_find(w, "dem_wall_loads_reset", id);
    demi_wall *wall;
    if (i < 0) return DEM_ERROR_ARGUMENT;
    wall = &w->walls[i];
    memset(wall->loads.impulse, 0, sizeof wall->loads.impulse);
    wall->loads.torque_impulse = wall->loads.work = wall->loads.time = 0;
    return DEM_OK;
}

/* ---------------------------------------------------------------------------------------------
   >>search
   Which pairs might touch before the next rebuild: all with distance < Ra + Rb + skin, found by one
   of the methods below, stored in one canonical order (a ascending, then b), so that every method
   gives the same list and the same bits. A rebuild sorts bodies by cell, deals them to domains of
   about 2000, lists for each domain the pairs inside it and the pairs leading out, carries contact
   memory over, and lists the wall elements near each grain.
   --------------------------------------------------------------------------------------------- */

/* Row of a body in an array of four reals each; unsigned, which spares a sign to extend. */
#define DEMI_AT(array, body) ((array) + 4*(size_t)(uint32_t)(body))

/* Divides a box into cells no smaller than `least`, no more than about 4 for each of `count`. */
static void demi_cells_lay(const double *lo, const double *hi, double least, int count, int *cells,
                           double *size) {
    int k;
    for (;; least *= 1.26) {
        for (k = 0; k < 3; k++) cells[k] = (int)DEMI_MAX(1, DEMI_MIN((hi[k] - lo[k])/least, 1e6));
        if ((double)cells[0]*cells[1]*cells[2] <= 4.0*count + 64) break;
    }
    for (k = 0; k < 3; k++) size[k] = DEMI_MAX((hi[k] - lo[k])/cells[k], least*1e-9);
}
/* Bodies outside count to the nearest cell, so that everybody is in one. */
static int demi_cell_of(const double *origin, const double *size, const int *cells,
                        const dem_real *x) {
    int c[3], k;
    for (k = 0; k < 3; k++) {
        const double t = ((double)x[k] - origin[k])/size[k];
        c[k] = !(t > 0) ? 0 : t >= cells[k] ? cells[k] - 1 : (int)t;
    }
    return c[0] + cells[0]*(c[1] + cells[1]*c[2]);
}

/* Lays the grid that bodies are sorted by; then the cell of each body. 0 when memory ran out. */
static int demi_grid_lay(dem_world *w, double least) {
    double lo[3], hi[3];
    int i, k, n;
    demi_domain_limits(w, lo, hi);
    for (k = 0; k < 3; k++) {
        const int periodic = w->desc.boundary[k] == DEM_BOUNDARY_PERIODIC;
        if (periodic) continue;
        lo[k] = w->bodies.count ? (double)w->bodies.pos[k] : 0;
        hi[k] = lo[k];
        for (i = 1; i < w->bodies.count; i++) {
            const double x = (double)w->bodies.pos[4*i + k];
            lo[k] = DEMI_MIN(lo[k], x);
            hi[k] = DEMI_MAX(hi[k], x);
        }
    }
    demi_cells_lay(lo, hi, least, w->bodies.count, w->cells, w->cell_size);
    for (k = 0; k < 3; k++) w->cell_origin[k] = lo[k];
    n = w->cells[0]*w->cells[1]*w->cells[2];
    if (!DEMI_GROW(w, w->cell_start, (size_t)n + 2)) return 0;
    for (i = 0; i < w->bodies.count; i++)
        w->bodies.cell_of[i] =
            demi_cell_of(w->cell_origin, w->cell_size, w->cells, w->bodies.pos + 4*i);
    return 1;
}

/* Puts what bodies have of it in the order of bodies.order. The sizes there are, by name: copies of
   constant length are instructions, others calls. */
static void demi_permute(dem_world *w, const demi_body_array *a) {
    char *to = (char *)w->bodies.scratch;
    const char *from = demi_data(w, a);
    const size_t n = (size_t)w->bodies.count;
    size_t i;
#define DEMI_PERMUTE(size) \
    for (i = 0; i < n; i++) memcpy(to + i*(size), from + (size_t)w->bodies.order[i]*(size), size)
    if (a->item == 4*sizeof(dem_real)) DEMI_PERMUTE(4*sizeof(dem_real));
    else if (a->item == sizeof(dem_real)) DEMI_PERMUTE(sizeof(dem_real));
    else if (a->item == sizeof(int32_t)) DEMI_PERMUTE(sizeof(int32_t));
    else DEMI_PERMUTE(a->item);
#undef DEMI_PERMUTE
    memcpy(demi_data(w, a), to, n*a->item);
}
/* Puts the bodies of cell c, in their order, at order[start[c]] .. order[start[c + 1] - 1]. Answers
   whether they stood so already. */
static int demi_cells_fill(dem_world *w, int n) {
    int32_t *start = w->cell_start;
    int i, sorted = 1;
    memset(start, 0, ((size_t)n + 2)*sizeof(int32_t));
    for (i = 0; i < w->bodies.count; i++) {
        start[w->bodies.cell_of[i] + 2]++;
        if (i && w->bodies.cell_of[i] < w->bodies.cell_of[i - 1]) sorted = 0;
    }
    for (i = 2; i < n + 2; i++) start[i] += start[i - 1];
    for (i = 0; i < w->bodies.count; i++) w->bodies.order[start[w->bodies.cell_of[i] + 1]++] = i;
    return sorted;
}
/* Sorts bodies by cell; within a cell they keep their order. */
static void demi_bodies_sort(dem_world *w) {
    int i;
    if (demi_cells_fill(w, w->cells[0]*w->cells[1]*w->cells[2])) return;
    for (i = 0; i < DEMI_BODY_ARRAYS; i++) {
        const demi_body_array *a = &demi_body_arrays[i];
        if (demi_keeps(w, a)) demi_permute(w, a);
    }
    for (i = 0; i < w->bodies.count; i++) w->bodies.slot_index[w->bodies.slot[i]] = i;
}

/* Memory of a pair in the filed list: its place, or -1; *flip when a and b have changed places
   since. */
static int demi_carry_find(const dem_world *w, int a, int b, int *flip) {
    const int32_t sa = (int32_t)w->bodies.slot[a], sb = (int32_t)w->bodies.slot[b];
    const int32_t row = DEMI_MIN(sa, sb), other = DEMI_MAX(sa, sb);
    int k;
    if (!w->filed.count || row >= w->filed.rows) return -1;
    if (w->filed.stride != w->memory_stride) return -1;     /* of other laws: it means nothing */
    for (k = w->filed.start[row]; k < w->filed.start[row + 1]; k++) {
        const int32_t p = w->filed.partner[k];
        if (p == other) { *flip = sa > sb; return k; }
        if (p == ~other) { *flip = sa < sb; return k; }
    }
    return -1;
}

/* Notes which image of b is nearest to a. It stays so until the next list: positions are brought
   back into the periodic box only then, and a period holds more than two candidates' lengths. */
static unsigned char demi_pair_image(const dem_world *w, const demi_periods *p, int a, int b) {
    const dem_real *x = w->bodies.pos + 4*a, *y = w->bodies.pos + 4*b;
    int code = 0, e, weight = 4;
    for (e = 0; e < 3; e++, weight *= 3) {
        const dem_real d = y[e] - x[e];
        code += d < -p->half[e] ? weight : d > p->half[e] ? 2*weight : 0;
    }
    return (unsigned char)code;
}
/* Where the 27 images of a body are; candidates name theirs by its number, a byte. */
static void demi_image_shifts(dem_world *w) {
    const demi_periods p = demi_periods_of(w);
    int code, e;
    for (code = 0; code < 27; code++)
        for (e = 0; e < 3; e++) {
            const int c = code/(e == 0 ? 1 : e == 1 ? 3 : 9)%3;
            w->image_shift[4*code + e] = c == 0 ? 0 : c == 1 ? p.period[e] : -p.period[e];
        }
}

/* Bounding spheres say little of long bodies: do they reach each other, but for the skin, along the
   line of their centres? */
static int demi_pair_reaches(const dem_world *w, int a, int b, dem_vec3 gap, dem_real skin) {
    const dem_real d = demi_length(gap);
    dem_vec3 n;
    if (!(d > 0)) return 1;
    n = demi_scale(gap, 1/d);
    return d - demi_support(w, a, n) - demi_support(w, b, demi_scale(n, -1)) < skin;
}

/* Tests one pair (a < b) and, if near enough, enters it in the list of a's domain. */
static void demi_pair_offer(dem_world *w, int d, const demi_periods *p, dem_real skin, int a,
                            int b) {
    const dem_real *x = w->bodies.pos + 4*a, *y = w->bodies.pos + 4*b;
    const dem_real dx = demi_image(y[0] - x[0], p->half[0], p->period[0]);
    const dem_real dy = demi_image(y[1] - x[1], p->half[1], p->period[1]);
    const dem_real dz = demi_image(y[2] - x[2], p->half[2], p->period[2]);
    const dem_real cut = x[3] + y[3] + skin;
    demi_domain *domain = &w->domains[d];
    demi_list *list;
    int k;
    if (!(dx*dx + dy*dy + dz*dz < cut*cut)) return;
    if (w->effects.fixed_count && w->bodies.inv_mass[a] <= 0 && w->bodies.inv_mass[b] <= 0) return;
    if (demi_is_ghost(w, a) && demi_is_ghost(w, b)) return;
    if (w->effects.tight && !demi_pair_reaches(w, a, b, demi_v(dx, dy, dz), skin)) return;
    list = b < domain->end ? &w->own : &w->cross;
    k = list == &w->own ? domain->own : domain->cross;
    if (k >= list->stride) { domain->overflow |= list == &w->own ? 1 : 2; return; }
    if (list == &w->own) domain->own++; else domain->cross++;
    k += d*list->stride;
    list->a[k] = a;
    list->b[k] = b;
    list->image[k] = demi_pair_image(w, p, a, b);
}

/* --- methods: each offers, for every body a of domain d in turn, its possible partners b > a in
       ascending order --- */

/* Everybody with everybody: slow, and so plain that the others are tested against it. */
static void demi_rows_all_pairs(dem_world *w, int d) {
    const demi_periods p = demi_periods_of(w);
    int a, b;
    for (a = w->domains[d].begin; a < w->domains[d].end; a++)
        for (b = a + 1; b < w->bodies.count; b++)
            demi_pair_offer(w, d, &p, (dem_real)w->margin.skin, a, b);
}

/* Cell indices c-1, c, c+1 along an axis, wrapped when periodic, without doubles, ascending. */
static int demi_neighbours(int c, int n, int periodic, int *out) {
    int count = 0, k, j;
    for (k = -1; k <= 1; k++) {
        int q = c + k, seen = 0;
        if (q < 0 || q >= n) {
            if (!periodic) continue;
            q = (q + n)%n;
        }
        for (j = 0; j < count; j++) seen |= out[j] == q;
        if (!seen) out[count++] = q;
    }
    for (k = 1; k < count; k++)                 /* at most three: put in order */
        for (j = k; j > 0 && out[j] < out[j - 1]; j--) { int t = out[j]; out[j] = out[j - 1];
                                                        out[j - 1] = t; }
    return count;
}

/* Bodies stand in the order of their cells, so that a cell is a range of indices, and neighbouring
   cells along x are often one range together. Each pair is found once: in the lower cell, or the
   lower body. */
static void demi_rows_grid(dem_world *w, int d) {
    const demi_periods p = demi_periods_of(w);
    const int32_t *start = w->cell_start;
    int a, c, i, j, k, b, last = -1, ranges = 0;
    int32_t from[27], to[27];
    for (a = w->domains[d].begin; a < w->domains[d].end; a++) {
        c = w->bodies.cell_of[w->bodies.order[a]];
        if (c != last) {  /* bodies of a cell share the ranges of index to look at */
            int nx[3], ny[3], nz[3], cx, cy, cz, x = c%w->cells[0], y = c/w->cells[0]%w->cells[1];
            const int z = c/w->cells[0]/w->cells[1];
            cx = demi_neighbours(x, w->cells[0], w->desc.boundary[0] == DEM_BOUNDARY_PERIODIC, nx);
            cy = demi_neighbours(y, w->cells[1], w->desc.boundary[1] == DEM_BOUNDARY_PERIODIC, ny);
            cz = demi_neighbours(z, w->cells[2], w->desc.boundary[2] == DEM_BOUNDARY_PERIODIC, nz);
            ranges = 0;
            for (k = 0; k < cz; k++)
                for (j = 0; j < cy; j++)
                    for (i = 0; i < cx; i++) {
                        const int q = nx[i] + w->cells[0]*(ny[j] + w->cells[1]*nz[k]);
                        if (q < c || start[q] == start[q + 1]) continue;
                        if (ranges && to[ranges - 1] == start[q]) { to[ranges - 1] = start[q + 1];
                            continue; }
                        from[ranges] = start[q];
                        to[ranges++] = start[q + 1];
                    }
            last = c;
        }
        for (k = 0; k < ranges; k++)
            for (b = DEMI_MAX(from[k], a + 1); b < to[k];
                 b++) demi_pair_offer(w, d, &p, (dem_real)w->margin.skin, a, b);
    }
}

/* --- levels: a hierarchical grid [OGA12] for bodies of very different radii, where the cells of
       one grid, as wide as the largest body, would each hold thousands of small ones. Radii are put
       in classes; every class has a grid of its own, whose cells hold one or two of its bodies. A
       body looks at each class in turn, no farther than it reaches: at few cells of the coarser
       ones, at those that its surface crosses of the finer ones. It keeps the partners that stand
       after it and puts them in order; so each pair is found from one side, whichever stands first
       (there, small ones look for large ones only; here rows must come in order, in any domain).
       --- */

/* Estimated work of a search, in distance tests, for one level of `count` bodies of up to `radius`
   among a packing of volume `room`, with `finer` bodies in the levels below it. Bodies of the level
   look at 27 of its cells (9 in a plane), half of it for partners that stand after them; the finer
   ones and it find each other in about half of that; and whoever looks at a level at all pays for
   some 10 tests. */
static double demi_level_work(const dem_world *w, double radius, double room, double count,
                              double finer) {
    const double side = 2*radius + w->margin.skin, all = w->desc.planar ? 9 : 27;
    const double cell = w->desc.planar ? side*side : side*side*side;
    const double part = DEMI_MIN(cell/DEMI_MAX(room, 1e-300), 1/all);
    return count*part*(0.5*all*count + 0.25*all*finer) + 10*(count + finer);
}

/* Counts bodies by radius: class k holds those from radius_max/2^(k/2) down to sqrt 2 less; then
   top[k] is the largest of them and below[k] how many are in classes k and on. Answers the volume
   that all fill when each has a cube (square) of its own. */
static double demi_radii_count(const dem_world *w, double *top, int *below) {
    double limit[DEMI_LEVELS], room = 0;
    int i, k;
    for (k = 0; k < DEMI_LEVELS; k++) {
        limit[k] = k < 2 ? (double)w->effects.radius_max*(k ? 0.70710678118654752 : 1)
            : limit[k - 2]/2;
        top[k] = 0;
        below[k] = 0;
    }
    /* neighbours are often alike: from where k is */
    for (i = 0, k = 0; i < w->bodies.count; i++) {
        const double r = (double)w->bodies.pos[4*i + 3], side = 2*r;
        while (k > 0 && r > limit[k]) k--;
        while (k < DEMI_LEVELS - 1 && r <= limit[k + 1]) k++;
        below[k]++;
        top[k] = DEMI_MAX(top[k], r);
        room += w->desc.planar ? side*side : side*side*side;
    }
    for (k = DEMI_LEVELS - 1; k >= 0; k--) below[k] += below[k + 1];
    return room;
}

/* Works out which classes to join into levels so that a search costs least, whether levels pay, and
   with that the method when the choice is ours. All of it follows from radii and skin alone, and
   what bodies are sorted by is the same for every method: then so are all bits. */
static void demi_levels_choose(dem_world *w) {
    double top[DEMI_LEVELS], least[DEMI_LEVELS + 1], room, one;
    int below[DEMI_LEVELS + 1], next[DEMI_LEVELS + 1], i, k;
    const int alike = w->effects.radius_max <= 2*w->effects.radius_min;    /* enough for one grid */
    const int by_name = w->desc.search == DEM_SEARCH_LEVELS && w->asked.search != DEM_SEARCH_AUTO;
    w->levels.wide = w->levels.count = 0;
    w->levels.tests[0] = w->levels.tests[1] = 0;
    if (w->asked.search == DEM_SEARCH_AUTO) w->desc.search = DEM_SEARCH_GRID;
    if (!w->bodies.count || (alike && !by_name)) return;
    below[DEMI_LEVELS] = 0;
    room = demi_radii_count(w, top, below);
    least[DEMI_LEVELS] = 0;
    for (i = DEMI_LEVELS - 1; i >= 0; i--) {  /* best way to divide classes i and on */
        least[i] = least[i + 1];
        next[i] = i + 1;
        if (below[i] == below[i + 1]) continue;
        for (k = i + 1; k <= DEMI_LEVELS; k++) {
            const double work = least[k] + demi_level_work(w, top[i], room, below[i] - below[k],
                                                           below[k]);
            if (k > i + 1 && !(work < least[i])) continue;
            least[i] = work;
            next[i] = k;
        }
    }
    for (i = 0; i < DEMI_LEVELS; i = next[i]) {
        if (below[i] == below[next[i]]) continue;
        w->levels.level[w->levels.count].radius = w->levels.fine = top[i];
        w->levels.level[w->levels.count++].count = below[i] - below[next[i]];
    }
    one = demi_level_work(w, (double)w->effects.radius_max, room, w->bodies.count, 0);
    w->levels.wide = !alike && w->levels.count > 1 && 2*least[0] < one;
    w->levels.tests[0] = one/w->bodies.count;
    w->levels.tests[1] = least[0]/w->bodies.count;
    if (w->asked.search == DEM_SEARCH_AUTO && w->levels.wide) w->desc.search = DEM_SEARCH_LEVELS;
    if (w->desc.search == DEM_SEARCH_LEVELS) return;
    /* bodies are sorted by finer cells than those of the grid asked for: one level is that grid */
    w->levels.count = w->levels.wide && w->desc.search == DEM_SEARCH_GRID;
    w->levels.level[0].radius = (double)w->effects.radius_max;
    w->levels.level[0].count = w->bodies.count;
}

/* Lays the cells of all levels and deals the bodies, sorted by now, to them; the arrays that the
   sorting needed serve again. 0 when memory ran out. */
static int demi_levels_lay(dem_world *w) {
    double hi[3];
    int i, k, l, n = 0;
    for (k = 0; k < 3; k++) hi[k] = w->cell_origin[k] + w->cell_size[k]*w->cells[k];
    for (l = 0; l < w->levels.count; l++) {
        demi_level *level = &w->levels.level[l];
        demi_cells_lay(w->cell_origin, hi, 2*level->radius + w->margin.skin + 1e-300, level->count,
                       level->cells, level->size);
        level->first = n;
        n += level->cells[0]*level->cells[1]*level->cells[2];
    }
    if (!DEMI_GROW(w, w->cell_start, (size_t)n + 2)) return 0;
    for (i = 0; i < w->bodies.count; i++) {
        const demi_level *level = w->levels.level;
        while (level < w->levels.level + w->levels.count - 1 &&
               (double)w->bodies.pos[4*i + 3] <= level[1].radius)
            level++;
        w->bodies.cell_of[i] = level->first +
            demi_cell_of(w->cell_origin, level->size, level->cells, w->bodies.pos + 4*i);
    }
    demi_cells_fill(w, n);
    return 1;
}

/* Cells of a level along one axis within `reach` of x. On a periodic axis they may lie beyond its
   ends, and when they go all the way round, each is there once and `round` is set. */
typedef struct demi_stretch { int first, last, round; } demi_stretch;
/* Cells of a level, along one axis, that are within `reach` of x. */
static demi_stretch demi_level_span(const dem_world *w, const demi_level *level, int axis, double x,
                                 double reach) {
    const int n = level->cells[axis];
    const double at = (x - w->cell_origin[axis])/level->size[axis], far = reach/level->size[axis];
    demi_stretch s;
    s.round = 0;
    if (w->desc.boundary[axis] != DEM_BOUNDARY_PERIODIC) {
        s.first = (int)DEMI_MIN(DEMI_MAX(at - far, 0), n - 1);
        s.last = (int)DEMI_MIN(DEMI_MAX(at + far, 0), n - 1);
        return s;
    }
    s.round = 2*far + 2 >= n;
    s.first = s.round ? 0 : (int)(at - far + n) - n;       /* rounds down: at - far > -n */
    s.last = s.round ? n - 1 : (int)(at + far);
    return s;
}
/* Distance along one axis from x to the cell `c`, squared. */
DEM_INLINE double demi_level_gap2(const dem_world *w, const demi_level *level, int axis, double x,
                                  int c) {
    const double from = w->cell_origin[axis] + level->size[axis]*c - x;
    const double to = from + level->size[axis], gap = from > 0 ? from : to < 0 ? to : 0;
    return gap*gap;
}
/* Offers a the bodies after it in cells `first` to `last` of a row of cells along x. */
static void demi_level_offer(dem_world *w, int d, const demi_periods *p, int a, int row,
                             int first, int last) {
    const int32_t *start = w->cell_start;
    const int end = start[row + last + 1];
    int i;
    for (i = start[row + first]; i < end; i++)
        if (w->bodies.order[i] > a)
            demi_pair_offer(w, d, p, (dem_real)w->margin.skin, a, w->bodies.order[i]);
}
/* Offers a what it can reach in one level. */
static void demi_row_level(dem_world *w, int d, const demi_periods *p, int a,
                           const demi_level *level) {
    const dem_real *at = w->bodies.pos + 4*a;
    const double x = (double)at[0], y = (double)at[1], z = (double)at[2];
    const int *n = level->cells;
    /* what round-off of distances over a whole period may add */
    const double slack = (DEMI_SINGLE ? 4e-7 : 1e-14)*(w->cell_size[0]*w->cells[0] +
        w->cell_size[1]*w->cells[1] + w->cell_size[2]*w->cells[2]);
    const double reach =
        ((double)w->bodies.pos[4*a + 3] + level->radius + w->margin.skin)*(1 + 1e-5) +
        slack;
    const demi_stretch sx = demi_level_span(w, level, 0, x, reach);
    const demi_stretch sy = demi_level_span(w, level, 1, y, reach);
    const demi_stretch sz = demi_level_span(w, level, 2, z, reach);
    int j, k;
    for (k = sz.first; k <= sz.last; k++) {
        const double left = reach*reach - (sz.round ? 0 : demi_level_gap2(w, level, 2, z, k));
        const int slice = level->first + n[0]*n[1]*(k < 0 ? k + n[2] : k >= n[2] ? k - n[2] : k);
        for (j = sy.first; j <= sy.last; j++) {
            const double still = left - (sy.round ? 0 : demi_level_gap2(w, level, 1, y, j));
            const int row = slice + n[0]*(j < 0 ? j + n[1] : j >= n[1] ? j - n[1] : j);
            demi_stretch s = sx;
            if (still < 0) continue;
            /* the row leaves the sphere of reach before it leaves the cube around it */
            if (s.last - s.first > 3 && !s.round) s = demi_level_span(w, level, 0, x, sqrt(still));
            if (s.first < 0) {
                demi_level_offer(w, d, p, a, row, s.first + n[0], n[0] - 1);
                s.first = 0;
            }
            if (s.last >= n[0]) {
                demi_level_offer(w, d, p, a, row, 0, s.last - n[0]);
                s.last = n[0] - 1;
            }
            demi_level_offer(w, d, p, a, row, s.first, s.last);
        }
    }
}

/* Sorts few numbers by insertion, many as a heap: no memory, no bad case. */
static void demi_heap_sink(int32_t *v, int at, int n) {
    const int32_t t = v[at];
    int child;
    for (; (child = 2*at + 1) < n; at = child) {
        if (child + 1 < n && v[child + 1] > v[child]) child++;
        if (v[child] <= t) break;
        v[at] = v[child];
    }
    v[at] = t;
}
/* Few by insertion, many by Williams' heap sort: no recursion, no memory. */
static void demi_ints_sort(int32_t *v, int n) {
    int i, j;
    if (n <= 32) {
        for (i = 1; i < n; i++) {
            const int32_t t = v[i];
            for (j = i; j > 0 && v[j - 1] > t; j--) v[j] = v[j - 1];
            v[j] = t;
        }
        return;
    }
    for (i = n/2 - 1; i >= 0; i--) demi_heap_sink(v, i, n);
    for (i = n - 1; i > 0; i--) {
        const int32_t t = v[0];
        v[0] = v[i];
        v[i] = t;
        demi_heap_sink(v, 0, i);
    }
}
/* Puts the partners of one body, entries `from` to `to` of the domain, in order. Partner and image
   travel as one number: there are fewer than INT_MAX/64 bodies, and 27 images, told in fours. */
static void demi_row_sort(const demi_list *list, int d, int from, int to) {
    int32_t *b = list->b + d*list->stride;
    unsigned char *image = list->image + d*list->stride;
    int k;
    for (k = from + 1; k < to && b[k - 1] < b[k]; k++) {}
    if (k >= to) return;
    for (k = from; k < to; k++) b[k] = 32*b[k] + image[k]/4;
    demi_ints_sort(b + from, to - from);
    for (k = from; k < to; k++) {
        image[k] = (unsigned char)(b[k]%32*4);
        b[k] /= 32;
    }
}
/* Each body against all levels, its partners then put in order: rows are those of one grid. */
static void demi_rows_levels(dem_world *w, int d) {
    const demi_periods p = demi_periods_of(w);
    const demi_domain *domain = &w->domains[d];
    int a, l;
    for (a = domain->begin; a < domain->end; a++) {
        const int own = domain->own, cross = domain->cross;
        for (l = 0; l < w->levels.count; l++) demi_row_level(w, d, &p, a, &w->levels.level[l]);
        demi_row_sort(&w->own, d, own, domain->own);
        demi_row_sort(&w->cross, d, cross, domain->cross);
    }
}

/* --- linked linear list [ALK07] 2.3.2. On each axis the ends of all boxes stand in one sorted
   list. A move
       sorts it again by exchanges of neighbours; when the lower end of one box passes the upper end
       of another, the two begin or cease to overlap on that axis, and the pair table is told. Boxes
       are those of radius + skin/2. Along a periodic axis every box counts as endless: correct, and
       slow. --- */
typedef struct demi_pair_key { int32_t lo, hi; } demi_pair_key;          /* slots; lo = -1: empty */

static size_t demi_pair_hash(int32_t lo, int32_t hi, size_t room) {
    uint64_t x = ((uint64_t)(uint32_t)lo << 32 | (uint32_t)hi)*UINT64_C(0x9E3779B97F4A7C15);
    return (size_t)(x >> 20) & (room - 1);
}
/* Open addressing with a power of two of places, at most two thirds full; deletion closes the gap.
   */
static int demi_pair_table_add(dem_world *w, int32_t a, int32_t b) {
    demi_pair_key *table = w->lll_table;
    size_t room = demi_room(table, sizeof *table), k;
    const int32_t lo = DEMI_MIN(a, b), hi = DEMI_MAX(a, b);
    if (3*(size_t)(w->lll_size + 1) > 2*room) {
        const size_t fresh_room = room ? 2*room : 1024;
        demi_pair_key *fresh = (demi_pair_key *)demi_hold(w, DEMI_RUN, fresh_room, sizeof *fresh);
        size_t i;
        if (!fresh) return 0;
        for (i = 0; i < fresh_room; i++) fresh[i].lo = -1;
        for (i = 0; i < room; i++) {
            if (table[i].lo < 0) continue;
            k = demi_pair_hash(table[i].lo, table[i].hi, fresh_room);
            while (fresh[k].lo >= 0) k = (k + 1) & (fresh_room - 1);
            fresh[k] = table[i];
        }
        demi_free(w, table);
        w->lll_table = table = fresh;
        room = fresh_room;
    }
    for (k = demi_pair_hash(lo, hi, room); table[k].lo >= 0; k = (k + 1) & (room - 1))
        if (table[k].lo == lo && table[k].hi == hi) return 1;
    table[k].lo = lo;
    table[k].hi = hi;
    w->lll_size++;
    return 1;
}
/* Open addressing without tombstones: what stood behind moves up, so that no search stops at a gap
   [Knuth, 6.4, algorithm R]. */
static void demi_pair_table_remove(dem_world *w, int32_t a, int32_t b) {
    demi_pair_key *table = w->lll_table;
    const size_t room = demi_room(table, sizeof *table);
    const int32_t lo = DEMI_MIN(a, b), hi = DEMI_MAX(a, b);
    size_t k, gap;
    if (!room) return;
    for (k = demi_pair_hash(lo, hi, room); table[k].lo != lo || table[k].hi != hi;
         k = (k + 1) & (room - 1))
        if (table[k].lo < 0) return;
    w->lll_size--;
    for (gap = k;;) {
        size_t home;
        table[gap].lo = -1;
        do {
            k = (k + 1) & (room - 1);
            if (table[k].lo < 0) return;
            home = demi_pair_hash(table[k].lo, table[k].hi, room);
        } while (gap <= k ? gap < home && home <= k : gap < home || home <= k);
        table[gap] = table[k];
        gap = k;
    }
}
static dem_real demi_box_end(const dem_world *w, int slot, int axis, int upper) {
    const int i = w->bodies.slot_index[slot];
    const dem_real grow = w->bodies.pos[4*i + 3] + (dem_real)w->margin.skin/2;
    return upper ? w->bodies.pos[4*i + axis] + grow : w->bodies.pos[4*i + axis] - grow;
}
/* Do the boxes of two bodies, by slot, overlap on every axis that is not periodic? */
static int demi_boxes_overlap(const dem_world *w, int s, int t) {
    int k;
    for (k = 0; k < 3; k++) {
        if (w->desc.boundary[k] == DEM_BOUNDARY_PERIODIC) continue;
        if (demi_box_end(w, s, k, 1) < demi_box_end(w, t, k, 0)) return 0;
        if (demi_box_end(w, t, k, 1) < demi_box_end(w, s, k, 0)) return 0;
    }
    return 1;
}
/* a total order: lower ends first */
static int demi_end_before(const demi_end *x, const demi_end *y) {
    if (x->value < y->value) return 1;
    if (x->value > y->value) return 0;
    if (x->upper != y->upper) return x->upper < y->upper;
    return x->box < y->box;
}
static int demi_end_compare(const void *x, const void *y) {
    return demi_end_before((const demi_end *)x, (const demi_end *)y) ? -1 : 1;
}
/* First time, or after bodies came or went: sort outright and sweep the first axis that is not
   periodic. */
static int demi_lll_start(dem_world *w) {
    const int n = w->bodies.count;
    size_t i;
    int axis, k, j, open = 0, sweep = 0;
    int32_t *active;
    demi_end *ends;
    for (axis = 0; axis < 3; axis++) {
        if (!DEMI_GROW(w, w->lll_ends[axis], (size_t)n*2)) return 0;
        ends = w->lll_ends[axis];
        for (k = 0; k < 2*n; k++) {
            ends[k].box = (int32_t)w->bodies.slot[k/2];
            ends[k].upper = k & 1;
            ends[k].value = demi_box_end(w, ends[k].box, axis, k & 1);
        }
        if (n) qsort(ends, (size_t)n*2, sizeof *ends, demi_end_compare);
    }
    for (i = 0; i < demi_room(w->lll_table, sizeof *w->lll_table); i++) w->lll_table[i].lo = -1;
    w->lll_size = 0;
    w->lll_boxes = n;
    while (sweep < 3 && w->desc.boundary[sweep] == DEM_BOUNDARY_PERIODIC) sweep++;
    if (sweep == 3) {                           /* endless everywhere: every pair */
        for (k = 0; k < n; k++)
            for (j = k + 1; j < n; j++)
                if (!demi_pair_table_add(w, (int32_t)w->bodies.slot[k],
                                         (int32_t)w->bodies.slot[j])) return 0;
        return 1;
    }
    if (!DEMI_GROW(w, w->lll_rows, (size_t)n)) return 0;
    active = w->lll_rows;
    ends = w->lll_ends[sweep];
    for (k = 0; k < 2*n; k++) {
        if (ends[k].upper) {
            for (j = 0; active[j] != ends[k].box; j++) {}
            active[j] = active[--open];
            continue;
        }
        for (j = 0; j < open; j++)
            if (demi_boxes_overlap(w, active[j], ends[k].box) &&
                !demi_pair_table_add(w, active[j], ends[k].box)) return 0;
        active[open++] = ends[k].box;
    }
    return 1;
}
/* The permutation update: insertion sort, exchanges told to the pair table. */
static int demi_lll_update(dem_world *w) {
    int axis, k, j;
    for (axis = 0; axis < 3; axis++) {
        demi_end *ends = w->lll_ends[axis];
        for (k = 0; k < 2*w->lll_boxes; k++)
            ends[k].value = demi_box_end(w, ends[k].box, axis, ends[k].upper);
        for (k = 1; k < 2*w->lll_boxes; k++) {
            const demi_end e = ends[k];
            for (j = k; j > 0 && demi_end_before(&e, &ends[j - 1]); j--) {
                const demi_end *f = &ends[j - 1];
                if (e.upper != f->upper && e.box != f->box &&
                    w->desc.boundary[axis] != DEM_BOUNDARY_PERIODIC) {
                    /* [f e] -> e before f: apart */
                    if (e.upper) demi_pair_table_remove(w, e.box, f->box);
                    /* lower end passes upper end */
                    else if (demi_boxes_overlap(w, e.box, f->box) &&
                             !demi_pair_table_add(w, e.box, f->box)) return 0;
                }
                ends[j] = ends[j - 1];
            }
            ends[j] = e;
        }
    }
    return 1;
}
static int demi_int_compare(const void *x, const void *y) {
    const int32_t a = *(const int32_t *)x, b = *(const int32_t *)y;
    return a < b ? -1 : a > b;
}
/* The table's pairs as rows of b by a, ascending. 0 when memory ran out. */
static int demi_lll_rows(dem_world *w) {
    int32_t *start, *rows;
    size_t i;
    int k, pass, fresh;
    fresh = !w->lll_valid;
    w->lll_valid = 0;                           /* until it is whole again */
    if (fresh ? !demi_lll_start(w) : !demi_lll_update(w)) return 0;
    w->lll_valid = 1;
    if (!DEMI_GROW(w, w->lll_row_start, (size_t)w->bodies.count + 2) ||
        !DEMI_GROW(w, w->lll_rows, (size_t)w->lll_size)) return 0;
    start = w->lll_row_start;
    rows = w->lll_rows;
    memset(start, 0, ((size_t)w->bodies.count + 2)*sizeof(int32_t));
    for (pass = 0; pass < 2; pass++) {
        for (i = 0; i < demi_room(w->lll_table, sizeof *w->lll_table); i++) {
            const demi_pair_key *key = w->lll_table + i;
            int a, b;
            if (key->lo < 0) continue;
            a = w->bodies.slot_index[key->lo];
            b = w->bodies.slot_index[key->hi];
            if (pass == 0) start[DEMI_MIN(a, b) + 2]++;
            else rows[start[DEMI_MIN(a, b) + 1]++] = DEMI_MAX(a, b);
        }
        if (pass == 0) for (k = 2; k < w->bodies.count + 2; k++) start[k] += start[k - 1];
    }
    for (k = 0; k < w->bodies.count; k++)
        if (start[k + 1] > start[k])
            qsort(rows + start[k], (size_t)(start[k + 1] - start[k]), sizeof *rows,
                  demi_int_compare);
    return 1;
}
/* The pairs of the table, by their lower body, as demi_lll_rows has put them. */
static void demi_rows_linked(dem_world *w, int d) {
    const demi_periods p = demi_periods_of(w);
    const int32_t *start = w->lll_row_start;
    const int32_t *rows = w->lll_rows;
    int a, k;
    for (a = w->domains[d].begin; a < w->domains[d].end; a++)
        for (k = start[a]; k < start[a + 1]; k++)
            demi_pair_offer(w, d, &p, (dem_real)w->margin.skin, a, rows[k]);
}

/* --- what is common --- */

/* By cells: of one size, or of several (levels). */
static void demi_rows_cells(dem_world *w, int d) {
    if (w->levels.count) demi_rows_levels(w, d); else demi_rows_grid(w, d);
}
/* Searches, a row each, in the order of their enum (>>add-search): name in reports; a domain's
   candidates, all of which go through demi_pair_offer; what is laid before, 0 when memory ran out
   (none: cells are enough); 1 where the bodies of a cell are compared with each other, so that
   crowds in one cell cost. All find the same pairs. */
typedef struct demi_search_row {
    const char *name;
    void (*rows)(dem_world *w, int d);
    int (*lay)(dem_world *w);
    int crowds;
} demi_search_row;
static const demi_search_row demi_searches[] = {
    {"automatic", demi_rows_cells, 0, 1},       /* becomes one of the others at the first list */
    {"all pairs", demi_rows_all_pairs, 0, 0},
    {"uniform grid", demi_rows_cells, 0, 1},
    {"linked linear list", demi_rows_linked, demi_lll_rows, 0},
    {"levels (hierarchical grid)", demi_rows_cells, 0, 1},
};
enum { DEMI_SEARCHES = (int)(sizeof demi_searches/sizeof *demi_searches) };

/* One domain's candidates, by the search in force. */
static void demi_domain_search(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    domain->own = domain->cross = 0;
    domain->overflow &= ~3;
    demi_searches[w->desc.search].rows(w, d);
}

/* ---------------------------------------------------------------------------------------------
   >>lists
   What a rebuild puts next to the neighbour list: candidates on walls (elements that a body may
   touch before the next rebuild), room for all lists, and the contacts that are kept (>>kept): they
   go from the lists of before, by slot, to those that are new. All
   room is made before anything moves, so that a rebuild which gets no memory has changed nothing.
   --------------------------------------------------------------------------------------------- */

/* Wall elements near a grain, ascending; offered to the domain's list of wall candidates. */
static void demi_wall_offer(dem_world *w, demi_domain *domain, int d, int body, int wall,
                            int element, dem_real gap, dem_vec3 shift) {
    int k = domain->walls;
    if (k >= w->wall_stride) { domain->overflow |= 4; return; }
    domain->walls++;
    k += d*w->wall_stride;
    w->wall_body[k] = body;
    w->wall_id[k] = wall;
    w->wall_element[k] = element;
    w->wall_gap[k] = gap - w->bodies.pos[4*body + 3]/10000;    /* a little for rounding */
    demi_put(w->wall_shift + 3*(size_t)k, shift);
}
static dem_real demi_wall_distance(const demi_wall *wall, int element, dem_vec3 local,
                                   dem_real enough);
/* The candidates of one body and wall, from `first` on: ascending by element, each once, so that
   the order does not hang on cells. */
static void demi_walls_order(dem_world *w, demi_domain *domain, int d, int first) {
    int32_t *e = w->wall_element + d*w->wall_stride;
    dem_real *gap = w->wall_gap + d*w->wall_stride;
    const int count = domain->walls - first;
    int step, i, k, n = first;
    for (step = 1; step < count/3; step = 3*step + 1) continue;
    for (; step > 0; step /= 3)                 /* Shell's sort */
        for (k = first + step; k < domain->walls; k++) {
            const int32_t t = e[k];
            const dem_real g = gap[k];
            for (i = k; i >= first + step && e[i - step] > t; i -= step) {
                e[i] = e[i - step];
                gap[i] = gap[i - step];
            }
            e[i] = t;
            gap[i] = g;
        }
    for (k = first; k < domain->walls; k++) {
        if (k > first && e[k] == e[k - 1]) continue;
        e[n] = e[k];
        gap[n++] = gap[k];
    }
    domain->walls = n;
}
/* Elements of one wall near body i as it is seen `shift` farther on. */
static void demi_wall_look(dem_world *w, demi_domain *domain, int d, int i, int j, dem_vec3 shift) {
    const demi_wall *wall = &w->walls[j];
    const dem_real r = w->bodies.pos[4*i + 3], near_by = r + (dem_real)w->margin.skin;
    const int first = domain->walls;
    const dem_vec3 out = demi_v(near_by, near_by, near_by);
    dem_vec3 at = demi_unrotate(wall->pose.rotation,
                              demi_sub(demi_add(demi_at(w->bodies.pos + 4*i), shift),
                                                            wall->pose.position));
    dem_real away;
    int k, x, y, z, f[3], l[3];
    if (demi_wall_is(wall, DEMI_DRAWN)) at.z = 0;
    if (!wall->cell_start) {
        for (k = 0; k < wall->element_count; k++) {
            away = demi_wall_distance(wall, k, at, near_by);
            if (away < near_by) demi_wall_offer(w, domain, d, i, j, k, away - r, shift);
        }
    } else {
        demi_wall_cells(wall, demi_sub(at, out), demi_add(at, out), f, l);
        for (z = f[2]; z <= l[2]; z++)
            for (y = f[1]; y <= l[1]; y++)
                for (x = f[0]; x <= l[0]; x++) {
                    const int cell = x + wall->cells[0]*(y + wall->cells[1]*z);
                    for (k = wall->cell_start[cell]; k < wall->cell_start[cell + 1]; k++) {
                        const int element = wall->cell_items[k];
                        const int32_t *e = w->wall_element + d*w->wall_stride;
                        int q = DEMI_MAX(first, domain->walls - 16);       /* rather not twice */
                        while (q < domain->walls && e[q] != element) q++;
                        if (q < domain->walls) continue;
                        away = demi_wall_distance(wall, element, at, near_by);
                        if (away < near_by)
                            demi_wall_offer(w, domain, d, i, j, element, away - r, shift);
                    }
                }
    }
    if (domain->walls > first) demi_walls_order(w, domain, d, first);
}
/* Elements of all walls near body i. */
static void demi_body_walls(dem_world *w, int d, int i) {
    demi_domain *domain = &w->domains[d];
    int j, a, b, c, f[3], l[3];
    if ((w->effects.fixed_count && w->bodies.inv_mass[i] <= 0) || demi_is_ghost(w, i)) return;
    for (j = 0; j < w->wall_count; j++) {
        const demi_wall *wall = &w->walls[j];
        if (wall->kind == DEMI_WALL_NONE) continue;
        if (!w->repeating) {
            demi_wall_look(w, domain, d, i, j, demi_v(0, 0, 0));
            continue;
        }
        demi_wall_images(w, wall, demi_at(w->bodies.pos + 4*i),
                         w->bodies.pos[4*i + 3] + (dem_real)w->margin.skin, f, l);
        for (c = f[2]; c <= l[2]; c++)
            for (b = f[1]; b <= l[1]; b++)
                for (a = f[0]; a <= l[0]; a++)
                    demi_wall_look(w, domain, d, i, j, demi_wall_shift(w, a, b, c));
    }
}
/* Candidates on walls of one domain, body by body; those of a body and wall stand together. */
static void demi_domain_walls(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    int i;
    domain->walls = 0;
    domain->overflow &= ~4;
    for (i = domain->begin; i < domain->end; i++) demi_body_walls(w, d, i);
}

/* Room for a list. 0 when memory ran out; what did grow is pointed at all the same. */
static int demi_list_reserve(dem_world *w, demi_list *list, int domains, int stride) {
    const size_t n = (size_t)domains*(size_t)stride;
    const int ok = n <= (size_t)INT_MAX/8 && DEMI_GROW(w, list->a, n) &&
                   DEMI_GROW(w, list->b, n) &&
                   DEMI_GROW(w, list->place, n) &&
                   DEMI_GROW(w, list->image, n);
    if (ok) list->stride = stride;
    return ok;
}
/* Has every near pair coefficients of its own? */
static int demi_many_species(const dem_world *w) {
    return w->effects.species_count > DEMI_SPECIES;
}
/* The same for the near list. */
static int demi_near_reserve(dem_world *w, demi_near *near, int domains, int stride) {
    const size_t n = (size_t)domains*(size_t)stride, m = n*(size_t)w->memory_stride;
    const int ok = n <= (size_t)INT_MAX/8 && DEMI_GROW(w, near->a, n) &&
                   DEMI_GROW(w, near->b, n) &&
                   DEMI_GROW(w, near->k, n) &&
                   DEMI_GROW(w, near->image, n) &&
                   DEMI_GROW(w, near->memory, m) &&
                   (w->effects.uniform || (demi_many_species(w)
                       ? DEMI_GROW(w, near->coef, n*DEMI_PAIR_COLUMNS)
                       : DEMI_GROW(w, near->row, n)));
    if (ok) near->stride = stride;
    return ok;
}
/* The same for candidates on walls. */
static int demi_wall_lists_reserve(dem_world *w, int stride) {
    const size_t n = (size_t)w->domain_count*(size_t)stride;
    const int ok = n <= (size_t)INT_MAX/8 && DEMI_GROW(w, w->wall_body, n) &&
                   DEMI_GROW(w, w->wall_id, n) &&
                   DEMI_GROW(w, w->wall_shift, 3*n) &&
                   DEMI_GROW(w, w->wall_gap, n) &&
                   DEMI_GROW(w, w->wall_element, n);
    if (ok) w->wall_stride = stride;
    return ok;
}
static int demi_cross_reserve(dem_world *w, size_t entries) {
    const int ok = DEMI_GROW(w, w->cross_incoming, entries) &&
                   DEMI_GROW(w, w->cross_force, 6*(entries + DEMI_LANES + 1));
    return ok;
}
/* The domain a body belongs to. */
static int demi_domain_of(const dem_world *w, int body) {
    int d = (int)((int64_t)body*w->domain_count/w->bodies.count);
    while (body >= w->domains[d].end) d++;
    while (body < w->domains[d].begin) d--;
    return d;
}
/* Entries of the cross lists by the domain of b, so that each domain can add what reaches in from
   before it. */
static int demi_cross_index(dem_world *w) {
    int d, k, e, entries = w->domain_count*w->cross.stride;
    if (!demi_cross_reserve(w, (size_t)entries)) return 0;
    for (d = 0; d <= w->domain_count; d++) w->cross_incoming_start[d] = 0;
    for (d = 0; d < w->domain_count; d++)
        for (k = 0; k < w->domains[d].cross; k++) {
            e = demi_domain_of(w, w->cross.b[d*w->cross.stride + k]);
            w->cross_incoming_start[e + 1]++;
        }
    for (d = 0; d < w->domain_count; d++)
        w->cross_incoming_start[d + 1] += w->cross_incoming_start[d];
    w->cross_entries = w->cross_incoming_start[w->domain_count];
    for (d = w->domain_count - 1; d >= 0; d--)
        for (k = w->domains[d].cross - 1; k >= 0; k--) {
            const int entry = d*w->cross.stride + k;
            e = demi_domain_of(w, w->cross.b[entry]);
            w->cross_incoming[--w->cross_incoming_start[e + 1]] = entry;
        }
    for (d = 0; d < w->domain_count; d++)
        w->cross_incoming_start[d] = w->cross_incoming_start[d + 1];
    w->cross_incoming_start[w->domain_count] = w->cross_entries;
    return 1;
}

/* Places that candidate k of domain d may give at most. */
static int demi_places_of(const dem_world *w, int d, int k) {
    const demi_wall *wall = &w->walls[w->wall_id[d*w->wall_stride + k]];
    const int32_t *cut = wall->cut_start ? wall->cut_start + w->wall_element[d*w->wall_stride + k]
        : 0;
    return demi_wall_kinds[wall->kind].most + (cut ? 2*(cut[1] - cut[0]) : 0);
}
/* The most contacts with walls that domain d may ever have with these candidates. */
static int demi_places_most(const dem_world *w, int d) {
    int k, n = 0;
    for (k = 0; k < w->domains[d].walls; k++) n += demi_places_of(w, d, k);
    return n;
}
/* Room for the places of one body and wall, for each domain its own. 0 when memory ran out. */
static int demi_touching_reserve(dem_world *w) {
    size_t n = 0;
    int d, k;
    for (d = 0; d < w->domain_count; d++) {
        const int32_t *body = w->wall_body + d*w->wall_stride, *id = w->wall_id + d*w->wall_stride;
        size_t most = DEMI_SIEVE_MOST, places = 0;
        w->domains[d].touching_first = (int)n;
        for (k = 0; k < w->domains[d].walls; k++) {
            if (k && (body[k] != body[k - 1] || id[k] != id[k - 1])) places = 0;
            places += (size_t)demi_places_of(w, d, k);
            most = DEMI_MAX(most, places);
        }
        n += most;
        if (n > (size_t)INT_MAX/8) return 0;
    }
    w->touching_valid = DEMI_GROW(w, w->touching, n) &&
                        DEMI_GROW(w, w->touching_links, n) &&
                        DEMI_GROW(w, w->touching_table, 4*n);
    return w->touching_valid;
}
/* Where each domain's contacts stand when there is room for what its candidates may give: as a rule
   hardly more than one contact for each, and what lasts (crowd), and a quarter. Slabs of spheres do
   not stop in the middle of a step to make room: as much as there may ever be. listed: domains in
   use; the others only hold what lasts. */
static void demi_kept_lay(const dem_world *w, int listed, const int *crowd, int *first) {
    int d;
    for (d = 0, first[0] = 0; d < DEMI_DOMAINS; d++) {
        const demi_domain *domain = &w->domains[d];
        int n = d < listed ? domain->walls : 0;
        if (d == listed - 1 && w->wall_count) n += w->join_room;
        n = DEMI_MAX(n, crowd[d]);
        n += n ? n/4 + 16 : 0;
        if (d < listed && w->bodies.ghost) n = DEMI_MAX(n, demi_places_most(w, d));
        if (d < listed && w->bodies.shaped) n += DEMI_MAX(64, 4*(domain->end - domain->begin));
        first[d + 1] = first[d] + n;
    }
}
/* Room for contacts in the domains of a new list, and for the walls' sums; nothing moves yet.
   first: where those of each domain will begin. 0 when memory ran out. */
static int demi_kept_room(dem_world *w, int *first) {
    int crowd[DEMI_DOMAINS], d, k, total = 0;
    memset(crowd, 0, sizeof crowd);
    for (d = 0; d < DEMI_DOMAINS; d++) total += w->domains[d].kept;
    for (d = 0; d < DEMI_DOMAINS; d++)          /* how many will come to each domain at most */
        for (k = 0; k < w->domains[d].kept; k++) {
            const demi_kept *c = demi_kept_of(w, d) + k;
            const int a = w->bodies.slot_index[c->a], b = c->b < 0 ? a : w->bodies.slot_index[c->b];
            if (a >= 0 && b >= 0) crowd[demi_domain_of(w, DEMI_MIN(a, b))]++;
        }
    demi_kept_lay(w, w->domain_count, crowd, first);
    return DEMI_GROW(w, w->wall_sums, (size_t)w->domain_count*(size_t)w->wall_count) &&
           DEMI_GROW(w, w->kept_next, (size_t)DEMI_MAX(first[DEMI_DOMAINS], total)) &&
           DEMI_GROW(w, w->kept_now, (size_t)first[DEMI_DOMAINS]);
}
/* Contacts that still last, from the last list (by slot) into the domains of the new one, each with
   its lower body as a: what turns round, turns round. */
static void demi_kept_move(dem_world *w, const int *first) {
    int d, k, e = 0, i;
    for (d = 0; d < DEMI_DOMAINS; d++) {
        for (k = 0; k < w->domains[d].kept; k++) {
            demi_kept c = demi_kept_of(w, d)[k];
            const int pair = c.b >= 0;
            c.a = w->bodies.slot_index[c.a];
            if (pair) c.b = w->bodies.slot_index[c.b];
            if (c.a < 0 || (pair && c.b < 0) ||
                (!pair && w->walls[c.wall].kind == DEMI_WALL_NONE)) continue;
            if (pair && c.b < c.a) {
                const dem_vec3 arm = c.arm_a;
                i = c.a; c.a = c.b; c.b = i;
                i = c.part_a; c.part_a = c.part_b; c.part_b = i;
                c.arm_a = c.arm_b; c.arm_b = arm;
                c.normal = demi_scale(c.normal, -1);
                c.lambda = c.lambda > 0 ? 1 - c.lambda : 0;
                for (i = 0; i < w->memory_stride; i++)
                    if (w->vector_mask >> i & 1) c.memory[i] = -c.memory[i];
            }
            c.coef_m = 0;                       /* materials may have changed */
            if (!pair && !demi_shape_of(w, c.a)) c.m_eff = w->bodies.mass[c.a];
            w->kept_next[e++] = c;
        }
        w->domains[d].kept = 0;
    }
    memcpy(w->kept_first, first, sizeof w->kept_first);
    /* deal out in the order of body a; `order` has done its work in the search and counts here */
    if (e) memset(w->bodies.order, 0, (size_t)w->bodies.count*sizeof *w->bodies.order);
    for (k = 0; k < e; k++) w->bodies.order[w->kept_next[k].a]++;
    for (d = 0; d < w->domain_count; d++)
        for (i = w->domains[d].begin; e && i < w->domains[d].end; i++) {
            const int here = w->bodies.order[i];
            w->bodies.order[i] = w->domains[d].kept;
            w->domains[d].kept += here;
        }
    for (k = 0; k < e; k++) {
        const demi_kept *c = &w->kept_next[k];
        demi_kept_of(w, demi_domain_of(w, c->a))[w->bodies.order[c->a]++] = *c;
    }
}

/* ---------------------------------------------------------------------------------------------
   >>near
   The near list: candidates that touch or may within margin.span, were they to meet head-on at the
   speed they have now; and margin.slack more, because speeds change. Forces are worked out for all
   of it, touching or not, so that a step neither looks at candidates nor packs them; what does not
   touch answers zero. It is made anew, from the candidates, when the time is over or accelerations
   may have used up the slack. Memory comes from the list before or, after a search, from where it
   was filed. Numbers do not depend on how long a list lasts: a zero more or less does not change a
   sum.
   Why nothing is missed: let v be the speed at which two bodies approach when the list is made. A
   step changes a velocity by at most last_change, dt times the largest acceleration of all; after n
   steps two have changed by at most 2 (change), change the sum of these. So they have come nearer
   than v t by at most creep, the sum over steps of 2 dt change. A pair that was left out had a gap
   of more than v span + slack: as long as the age is below span and creep below slack, it is open.
   --------------------------------------------------------------------------------------------- */

/* --- species: which spheres are alike, and the coefficients of every two kinds. A scene has few of
       them (one, two sizes of beads, balls and powder) or as many as grains (radii drawn at
       random), seldom something between. With few, a near pair carries the number of a row, 4 byte
       where its coefficients take 88, and tiles of pairs that are all of one row copy nothing; a
       single steel ball among glass beads then slows only the tiles that it is in. With many, each
       pair carries its own. The species are those of the last search: whoever comes in between, by
       a feed, must be of one of them (demi_species_known), or the list is made anew. --- */
static demi_species demi_species_of(const dem_world *w, int body) {
    demi_species s;
    s.radius = w->bodies.pos[4*body + 3];
    s.mass = w->bodies.mass[body];
    s.inv_mass = w->bodies.inv_mass[body];
    s.material = w->bodies.material[body];
    s.none = 0;
    return s;
}
/* Which one the body is of; species_count when of none. By every bit: a radius that differs in the
   last one has coefficients of its own. */
static int demi_species_find(const dem_world *w, int body) {
    const demi_species s = demi_species_of(w, body);
    int k;
    for (k = 0; k < w->effects.species_count; k++)
        if (!memcmp(&w->effects.species[k], &s, sizeof s)) break;
    return k;
}
/* Has the body coefficients with others? Not when a file names other species than its bodies
   are. */
static int demi_species_has(const dem_world *w, int body) {
    return demi_many_species(w) || demi_species_find(w, body) < w->effects.species_count;
}
/* Those of all spheres there are; of one more than have a table when there are more. */
static void demi_species_count(dem_world *w) {
    demi_in_force *e = &w->effects;
    int i;
    e->species_count = 0;
    for (i = 0; i < w->bodies.count && e->species_count <= DEMI_SPECIES; i++) {
        if (demi_shape_of(w, i) || demi_species_has(w, i)) continue;
        if (e->species_count < DEMI_SPECIES) e->species[e->species_count] = demi_species_of(w, i);
        e->species_count++;
    }
}
/* Coefficients of a pair. R* of equal radii is half of them to the last bit, so that two alike get
   what a world gets in which all are. */
static void demi_species_coefs(const dem_world *w, const demi_species *a, const demi_species *b,
                               dem_real *coef) {
    const double ra = (double)a->radius, rb = (double)b->radius;
    const double sum = (double)a->inv_mass + (double)b->inv_mass;
    /* there a fixed grain has mass too */
    const double inv = w->desc.convention == DEM_CONVENTION_MILL
        ? 1/(double)a->mass + 1/(double)b->mass : sum;
    demi_coefficients(w, a->material - 1, b->material - 1,
                      ra < rb || ra > rb ? ra*rb/(ra + rb) : ra/2, 1/inv, 1/inv, 0, coef);
    coef[DEMI_M_EFF] = (dem_real)(1/sum);
}
/* Which columns differ from pair to pair, and are asked for. In a table one can see it; of too many
   species it is those that hang on radii, and on materials where there are several. */
static void demi_species_vary(dem_world *w) {
    const int rows = w->effects.species_count*w->effects.species_count;
    const int fixed = 1 << DEMI_MU | 1 << DEMI_MU_STATIC | 1 << DEMI_MU_ROLL | 1 << DEMI_K_AD;
    int e, k, materials = 0;
    w->species_vary = (1 << DEMI_PAIR_COLUMNS) - 1;
    if (!demi_laws_sized(w)) w->species_vary &= ~(1 << DEMI_R_EFF | 1 << DEMI_M_EFF);
    if (demi_many_species(w)) {
        for (k = 0; k < w->bodies.count; k++)
            materials |= w->bodies.material[k]^w->bodies.material[0];
        if (!materials) w->species_vary &= ~fixed;
        if (!demi_normal_is(w, DEMI_BRANCHED))
            w->species_vary &= ~(1 << DEMI_K_UN | 1 << DEMI_K_AD);
        return;
    }
    for (e = 0; e < DEMI_PAIR_COLUMNS; e++) {
        const dem_real *column = w->species_coef + e;
        for (k = 1; k < rows; k++)
            if (memcmp(column, column + DEMI_PAIR_COLUMNS*k, sizeof *column)) break;
        if (k >= rows) w->species_vary &= ~(1 << e);
    }
}
/* Would a new sphere find its coefficients? */
static int demi_species_known(const dem_world *w, int material, dem_real radius) {
    const demi_species *s = w->effects.species;
    int k;
    for (k = 0; k < w->effects.species_count && !demi_many_species(w); k++)
        if (s[k].material == material + 1 && s[k].inv_mass > 0 && !(s[k].radius < radius) &&
            !(s[k].radius > radius)) return 1;
    /* a second material makes columns vary that did not */
    return demi_many_species(w) &&
           (w->species_vary >> DEMI_MU & 1 || w->bodies.material[0] == material + 1);
}
/* Room for the table; 0 when memory ran out. What is refused here is refused before any list is
   changed; filling the table cannot fail. */
static int demi_species_room(dem_world *w) {
    const size_t n = demi_many_species(w) ? 0 : (size_t)w->effects.species_count;
    return DEMI_GROW(w, w->species_coef, n*n*DEMI_PAIR_COLUMNS);
}
/* What is in it. */
static void demi_species_lay(dem_world *w) {
    const int n = w->effects.species_count;
    int k;
    for (k = 0; k < n*n && !demi_many_species(w); k++)
        demi_species_coefs(w, &w->effects.species[k/n], &w->effects.species[k%n],
                           w->species_coef + DEMI_PAIR_COLUMNS*k);
}
/* A pair learns its row, or is given columns; only needed where bodies differ. */
static void demi_near_coefs(const dem_world *w, demi_near *near, int d, int p, int a, int b) {
    const demi_species one = demi_species_of(w, a), other = demi_species_of(w, b);
    dem_real coef[DEMI_PAIR_COLUMNS], *to;
    int e;
    if (!demi_many_species(w)) {
        near->row[d*near->stride + p] = demi_species_find(w, a)*w->effects.species_count +
            demi_species_find(w, b);
        return;
    }
    demi_species_coefs(w, &one, &other, coef);
    to = near->coef + (size_t)d*DEMI_PAIR_COLUMNS*(size_t)near->stride + (size_t)p;
    for (e = 0; e < DEMI_PAIR_COLUMNS; e++) to[(size_t)e*(size_t)near->stride] = coef[e];
}
/* Entry `to` of the domain has the coefficients of entry `from`, of the same list or another. */
static void demi_near_coefs_copy(const dem_world *w, demi_near *near, int d, int to,
                                 const demi_near *last, int from) {
    const size_t columns = DEMI_PAIR_COLUMNS, stride = (size_t)near->stride;
    const size_t last_stride = (size_t)last->stride;
    dem_real *m;
    const dem_real *old;
    size_t e;
    if (w->effects.uniform) return;
    if (!demi_many_species(w)) {
        near->row[d*near->stride + to] = last->row[d*last->stride + from];
        return;
    }
    m = near->coef + (size_t)d*columns*stride + (size_t)to;
    old = last->coef + (size_t)d*columns*last_stride + (size_t)from;
    for (e = 0; e < columns; e++) m[e*stride] = old[e*last_stride];
}
/* Picks near ones from the candidates of one list, without a branch; their entries from p on.
   Answers where they end, or -1 when there is no room. */
DEM_INLINE int demi_near_pick_as(dem_world *w, const demi_list *list, int begin, int end, int d,
                                 int p, int mixed) {
    const dem_real *x = w->bodies.pos, *u = w->bodies.vel, *shift = w->image_shift;
    const dem_real margin = (dem_real)w->margin.slack, span = (dem_real)w->margin.span;
    const int room = w->near.stride - DEMI_LANES;
    const int32_t *shape = w->bodies.shape;
    int32_t *out = w->near.k + d*w->near.stride;
    int k;
    for (k = begin; k < end && p < room; k++) {
        const dem_real *a = DEMI_AT(x, list->a[k]), *b = DEMI_AT(x, list->b[k]);
        const dem_real *s = shift + list->image[k];
        const dem_real *ua = DEMI_AT(u, list->a[k]), *ub = DEMI_AT(u, list->b[k]);
        const dem_real dx = b[0] - a[0] + s[0], dy = b[1] - a[1] + s[1], dz = b[2] - a[2] + s[2];
        const dem_real ux = ub[0] - ua[0], uy = ub[1] - ua[1], uz = ub[2] - ua[2];
        const dem_real cut = a[3] + b[3] + margin + span*DEMI_SQRT(ux*ux + uy*uy + uz*uz);
        out[p] = k;
        p += (dx*dx + dy*dy + dz*dz < cut*cut) &
            (!mixed || !(shape[list->a[k]] | shape[list->b[k]]));
    }
    return k < end ? -1 : p;
}
static int demi_near_pick(dem_world *w, const demi_list *list, int begin, int end, int d, int p) {
    return w->bodies.shaped ? demi_near_pick_as(w, list, begin, end, d, p, 1)
        : demi_near_pick_as(w, list, begin, end, d, p, 0);
}
/* The same for pairs that are not of two spheres: by the distance of their surfaces, and with what
   their spins may bring. */
static int demi_near_pick_shaped(dem_world *w, const demi_list *list, int begin, int end, int d,
                                 int p) {
    const dem_real margin = (dem_real)w->margin.slack, span = (dem_real)w->margin.span;
    const int room = w->near.stride - DEMI_LANES;
    int32_t *out = w->near.k + d*w->near.stride;
    int k;
    for (k = begin; k < end && p < room; k++) {
        const int a = list->a[k], b = list->b[k];
        const demi_shape *fa = demi_shape_of(w, a), *fb = demi_shape_of(w, b);
        dem_real speed, cut;
        if (!fa && !fb) continue;
        speed = demi_length(demi_sub(demi_at(w->bodies.vel + 4*b), demi_at(w->bodies.vel + 4*a)));
        if (fa) speed += demi_length(demi_at(w->bodies.spin + 4*a))*fa->moment_arm*
                         demi_scale_of(w, a, fa);
        if (fb) speed += demi_length(demi_at(w->bodies.spin + 4*b))*fb->moment_arm*
                         demi_scale_of(w, b, fb);
        cut = margin + span*speed;
        out[p] = k;
        p += demi_bodies_gap(w, a, b, w->image_shift + list->image[k], cut) < cut;
    }
    return k < end ? -1 : p;
}
/* Memory and coefficients of the domain's entry p, which is new or was entry `from` before. */
static void demi_near_recall(dem_world *w, int d, int p, int from) {
    demi_near *near = &w->near;
    const demi_near *last = &w->near_last;
    const size_t keep = (size_t)w->memory_stride, stride = (size_t)near->stride;
    const size_t last_stride = (size_t)last->stride;
    const int at = d*near->stride + p;
    dem_real *m = near->memory + (size_t)d*keep*stride + (size_t)p;
    size_t e;
    int flip = 0;
    if (from >= 0) {
        const dem_real *old = last->memory + (size_t)d*keep*last_stride + (size_t)from;
        for (e = 0; e < keep; e++) m[e*stride] = old[e*last_stride];
        demi_near_coefs_copy(w, near, d, p, last, from);
        return;
    }
    if (!w->effects.uniform) demi_near_coefs(w, near, d, p, near->a[at], near->b[at]);
    for (e = 0; e < keep; e++) m[e*stride] = 0;
    if (!keep || !w->near_fresh ||
        (from = demi_carry_find(w, near->a[at], near->b[at], &flip)) < 0) return;
    for (e = 0; e < keep; e++) {
        const dem_real value = w->filed.memory[(size_t)from*keep + e];
        m[e*stride] = flip && (w->vector_mask >> e & 1) ? -value : value;
    }
}

/* What follows from the near list of a domain: groups are filled up with copies of their last pair,
   whose answers nobody reads (then no group is cut short), and candidates learn their entries. */
static void demi_near_adopt(dem_world *w, int d) {
    demi_near *near = &w->near;
    const demi_domain *domain = &w->domains[d];
    const size_t stride = (size_t)near->stride;
    dem_real *memory = w->memory_stride
        ? near->memory + (size_t)d*(size_t)w->memory_stride*stride : 0;
    int l, p, e;
    for (l = 0; l < 2; l++) {
        const int end = l ? domain->near_end : domain->near_own, at = d*near->stride;
        if (end == (l ? domain->near_cross : 0)) continue;
        for (p = end; p%DEMI_LANES; p++) {
            near->a[at + p] = near->a[at + end - 1];
            near->b[at + p] = near->b[at + end - 1];
            near->k[at + p] = near->k[at + end - 1];
            near->image[at + p] = near->image[at + end - 1];
            for (e = 0; e < w->memory_stride; e++) memory[(size_t)e*stride + (size_t)p] = 0;
            demi_near_coefs_copy(w, near, d, p, near, end - 1);
        }
    }
    for (l = 0; l < 2; l++) {
        demi_list *list = l ? &w->cross : &w->own;
        const int count = l ? domain->cross : domain->own;
        if (count) memset(list->place + d*list->stride, 0, (size_t)count*sizeof *list->place);
        for (p = l ? domain->near_cross : 0; p < (l ? domain->near_end : domain->near_own); p++)
            list->place[near->k[d*near->stride + p]] = p + 1;
        for (p = l ? domain->near_shaped_cross : domain->near_shaped;
             p < (l ? domain->near_shaped_end : domain->near_shaped_cross); p++)
            list->place[near->k[d*near->stride + p]] = p + 1;
    }
}
/* The near list that was being made is the one in use now; memory comes over with its pairs. */
static void demi_domain_adopt(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    domain->near_own = domain->near_next_own;
    domain->near_cross = domain->near_next_cross;
    domain->near_end = domain->near_next_end;
    domain->near_shaped = domain->near_next_shaped;
    domain->near_shaped_cross = domain->near_next_shaped_cross;
    domain->near_shaped_end = domain->near_next_shaped_end;
    demi_near_adopt(w, d);
}

/* Near pairs of one domain. */
static void demi_domain_near(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    demi_near *near = &w->near;
    int l, q, p = 0;
    domain->overflow &= ~8;
    for (l = 0; l < 2; l++) {
        const demi_list *list = l ? &w->cross : &w->own;
        const int begin = d*list->stride, end = begin + (l ? domain->cross : domain->own);
        const int first = p;
        p = demi_near_pick(w, list, begin, end, d, p);
        if (p < 0) { domain->overflow |= 8; return; }
        for (q = first; q < p; q++) {
            const int at = d*near->stride + q, k = near->k[at];
            near->a[at] = list->a[k];
            near->b[at] = list->b[k];
            near->image[at] = list->image[k];
            if (w->memory_stride || !w->effects.uniform)
                demi_near_recall(w, d, q, w->near_fresh ? -1 : list->place[k] - 1);
        }
        if (l) domain->near_next_end = p;
        else domain->near_next_own = p;
        p = (p + DEMI_LANES - 1)/DEMI_LANES*DEMI_LANES;
        if (!l) domain->near_next_cross = p;
    }
    domain->near_next_shaped = p;
    for (l = 0; l < 2; l++) {
        const demi_list *list = l ? &w->cross : &w->own;
        const int begin = d*list->stride, end = begin + (l ? domain->cross : domain->own);
        const int first = p;
        if (l) domain->near_next_shaped_cross = p;
        if (w->bodies.shaped) p = demi_near_pick_shaped(w, list, begin, end, d, p);
        if (p < 0) { domain->overflow |= 8; return; }
        for (q = first; q < p; q++) {
            const int at = d*near->stride + q, k = near->k[at];
            near->a[at] = list->a[k];
            near->b[at] = list->b[k];
            near->image[at] = list->image[k];
        }
    }
    domain->near_next_shaped_end = p;
}
/* --- quiet bodies: where nothing but near pairs and walls can push (no gravity, no force field,
       no other slab), bodies in none of those fly straight on until the next near list: only
       positions change. Told for DEMI_SOME bodies at a time. Skipping writes what was there, so
       bits are the same. --- */
typedef struct demi_quiet {
    int restless;                  /* 2: something may push; 1: not now, but did; 0: quiet */
    dem_real speed2;               /* the largest |v|^2 when last looked at */
} demi_quiet;
DEM_INLINE demi_quiet *demi_quiet_at(const dem_world *w, int d, int i) {
    return w->quiet + d + i/DEMI_SOME;     /* no two domains share one */
}
static int demi_quiet_possible(const dem_world *w) {
    const dem_vec3 g = w->desc.gravity;
    return !(demi_dot(g, g) > 0) && !w->desc.force && !w->desc.body_force && !w->bodies.ghost &&
           !w->bodies.backward;
}
/* Says of every few bodies whether anything is near any of them: where nothing is, and no field
   acts, they fly by themselves, and a step need not gather, nor clear, forces for them. */
static void demi_domain_quiet(dem_world *w, int d) {
    const demi_domain *domain = &w->domains[d];
    const demi_near *near = &w->near;
    int i, p, k;
    for (i = domain->begin; i < domain->end; i++) demi_quiet_at(w, d, i)->restless = 1;
    for (p = demi_near_first(domain); p < domain->near_end; p = demi_near_next(domain, p)) {
        demi_quiet_at(w, d, near->a[d*near->stride + p])->restless = 2;
        if (p < domain->near_own) demi_quiet_at(w, d, near->b[d*near->stride + p])->restless = 2;
    }
    for (p = domain->near_shaped; p < domain->near_shaped_end; p++) {
        demi_quiet_at(w, d, near->a[d*near->stride + p])->restless = 2;
        if (p < domain->near_shaped_cross)
            demi_quiet_at(w, d, near->b[d*near->stride + p])->restless = 2;
    }
    for (k = w->cross_incoming_start[d]; k < w->cross_incoming_start[d + 1]; k++)
        if (w->cross.place[w->cross_incoming[k]])
            demi_quiet_at(w, d, w->cross.b[w->cross_incoming[k]])->restless = 2;
    for (k = 0; k < domain->walls; k++)
        demi_quiet_at(w, d, w->wall_body[d*w->wall_stride + k])->restless = 2;
}

/* How long the next near list is to last, from counted work, so that it is the same on every run: a
   force costs 1; making the list, 0.15 for each candidate and 1 for each near pair (bench/ measures
   both). Pairs that do not touch grow with the span, how often the list is made shrinks with it. */
static void demi_near_choose(dem_world *w) {
    const double r = (double)(w->effects.radius_min > 0 ? w->effects.radius_min : 1),
        dt = (double)w->clock.dt;
    double near = 0, touching = 0, candidates = 0, longer = 1, span = w->margin.span;
    int d;
    if (span < dt) span = dt;                   /* the first of all */
    if (w->margin.age > 0) {
        for (d = 0; d < w->domain_count; d++) {
            const demi_domain *domain = &w->domains[d];
            near += domain->near_own + domain->near_end - domain->near_cross;
            near += 4*(domain->near_shaped_end - domain->near_shaped);
            touching += domain->contacts + 3*(domain->kept - domain->kept_walls);
            candidates += domain->own + domain->cross;
        }
        if (w->bodies.shaped) candidates *= 6;   /* supports, and some meetings */
        longer = sqrt((0.15*candidates + near)*dt/
                      (w->margin.age*DEMI_MAX(near - touching, 0.01*w->bodies.count)));
        longer = sqrt(DEMI_MIN(DEMI_MAX(longer, 0.5), 2.0));
        span = DEMI_MIN(DEMI_MAX(w->margin.age*longer, 2*dt), 1000*dt);
        /* creep grows with the square of time */
        w->margin.slack = w->margin.creep*span*span/(w->margin.age*w->margin.age)*1.2;
    }
    w->margin.slack = DEMI_MIN(DEMI_MAX(w->margin.slack, 1e-5*r), 0.1*r);
    w->margin.span = span;
}
/* A step has gone by, in which no velocity changed by more than `change`. */
static void demi_near_pass(dem_world *w, double change) {
    w->margin.last_change = change;
    w->margin.change += change;
    w->margin.creep += 2*w->margin.change*(double)w->clock.dt;
    w->margin.age += (double)w->clock.dt;
}
static int demi_near_due(const dem_world *w) {
    return w->margin.age > w->margin.span*(1 - 1e-9) || w->margin.creep > w->margin.slack;
}
/* Makes the near list; fresh: after a search. 0 when memory ran out: the list before is in use. */
static int demi_near_make(dem_world *w, int fresh) {
    const demi_near swap = w->near;
    int d, again, stride;
    w->near = w->near_last;
    w->near_last = swap;
    w->near_fresh = fresh;
    if (!DEMI_GROW(w, w->quiet, (size_t)(w->bodies.count/DEMI_SOME + w->domain_count + 1))) {
        w->near_last = w->near;
        w->near = swap;
        return 0;
    }
    stride = DEMI_MAX(w->near_last.stride, DEMI_MAX(64, w->bodies.count/w->domain_count*5/2));
    stride = (stride + DEMI_LANES - 1)/DEMI_LANES*DEMI_LANES;
    do {                                        /* until every domain's pairs fit */
        again = 0;
        if (demi_near_reserve(w, &w->near, w->domain_count, stride)) {
            demi_parallel(w, w->desc.threads, w->domain_count, demi_domain_near);
            for (d = 0; d < w->domain_count; d++) again |= w->domains[d].overflow & 8;
            stride = stride/4*5/DEMI_LANES*DEMI_LANES + 4*DEMI_LANES;
            continue;
        }
        w->near_last = w->near;
        w->near = swap;
        return 0;
    } while (again);
    demi_parallel(w, w->desc.threads, w->domain_count, demi_domain_adopt);
    if (!fresh && demi_quiet_possible(w))
        demi_parallel(w, w->desc.threads, w->domain_count, demi_domain_quiet);
    w->margin.age = w->margin.creep = 0;
    w->stage.near_stale = 0;
    /* speeds now, and those that move, are as much as this apart */
    w->margin.change = w->margin.last_change;
    return 1;
}

/* ---------------------------------------------------------------------------------------------
   >>rebuild
   Everything that hangs on which bodies are near which, made anew: the effects in force, the
   skin, the order of bodies, domains, lists. Why so often: a list is right as long as nobody has
   gone farther than half the skin (margin.gone), since all pairs nearer than the skin are in
   it; a wide skin makes lists last and each of them long, and the skin is chosen where both
   together cost least. Refusals come first: a rebuild that fails leaves places, memory and the
   old list as they were. New bodies may join a list that stands (demi_list_join).
   --------------------------------------------------------------------------------------------- */

/* What the laws in force keep per contact: the user's own what desc says, built-in ones what their
   rows say, one after the other (demi_laws_set). */
static void demi_effects_memory(dem_world *w) {
    demi_laws_set(&w->laws, w->normal, w->effects.tangent, w->effects.rolling);
    w->memory_stride = w->laws.memory;
    w->vector_mask = w->laws.vectors;
    if (!w->desc.law) return;
    w->memory_stride = w->desc.law_memory;
    w->vector_mask = (1 << 3*w->desc.law_vectors) - 1;
}
/* Does any pair of the scene have friction, or rolling friction? */
static void demi_pairs_rub(const dem_world *w, int *friction, int *rolling) {
    int i, j;
    *friction = *rolling = 0;
    for (i = 0; i < w->material_count; i++)
        for (j = 0; j < w->material_count; j++) {
            const dem_pair *p = &w->pairs[i*DEMI_MATERIALS + j].given;
            *friction |= p->friction > 0 || p->friction_static > 0;
            *rolling |= p->rolling_friction > 0;
        }
}
/* The effects of the live scene: which laws act, whether all bodies are alike. */
static void demi_effects(dem_world *w) {
    int i, friction, rolling;
    demi_pairs_rub(w, &friction, &rolling);
    w->normal = (int)w->desc.normal_law;
    w->effects.tangent = friction ? demi_tangent_meant(w) : DEM_TANGENT_NONE;
    w->effects.rolling = rolling ? demi_rolling_meant(w) : DEM_ROLLING_NONE;
    demi_effects_memory(w);
    w->effects.uniform = w->bodies.count > 0;
    w->effects.fixed_count = 0;
    w->effects.radius_min = w->effects.radius_max = w->bodies.count ? w->bodies.pos[3] : 0;
    for (i = 0; i < w->bodies.count; i++) {
        const dem_real r = w->bodies.pos[4*i + 3];
        w->effects.radius_min = DEMI_MIN(w->effects.radius_min, r);
        w->effects.radius_max = DEMI_MAX(w->effects.radius_max, r);
        w->effects.fixed_count += w->bodies.inv_mass[i] <= 0;
        w->effects.uniform &= w->bodies.material[i] == w->bodies.material[0];
    }
    w->effects.tight = 0;
    for (i = 0; i < w->bodies.count && w->bodies.shaped; i++) {
        const demi_shape *shape = demi_shape_of(w, i);
        w->effects.uniform &= w->bodies.shape[i] == w->bodies.shape[0];
        w->effects.tight |= shape && shape->radius > 2*shape->equal;
    }
    w->effects.uniform = w->effects.uniform && w->effects.radius_max <= w->effects.radius_min &&
        !w->effects.fixed_count;
    demi_species_count(w);
}

/* Skin from counted work, so that it is the same on every run: looking at a candidate costs 1, a
   search 40 per body (bench/ measures both); candidates, looked at whenever the near list is made,
   grow with the skin, searches shrink with it. */
static void demi_skin_choose(dem_world *w) {
    const double r = (double)(w->effects.radius_min > 0 ? w->effects.radius_min : 1);
    const double steps = (double)(w->clock.steps - w->clock.last_rebuild);
    int k;
    /* all bodies may be others by now */
    w->margin.skin_auto = DEMI_MIN(w->margin.skin_auto, 2*r);
    if (w->desc.skin > 0) { w->margin.skin = (double)w->desc.skin; return; }
    if (w->desc.skin < 0) { w->margin.skin = 0; return; }
    if (w->margin.skin_auto <= 0) w->margin.skin_auto = 0.1*r;
    else if (steps > 0 && w->clock.rebuilds > 1 && w->bodies.count > 0) {
        double n = 0, hits = 0, slope, best;
        const double per_step =
            DEMI_MAX(2*w->margin.gone, w->margin.gone + w->margin.walls_gone)/steps;
        const double looks = DEMI_MIN(DEMI_MAX(w->margin.span/(double)w->clock.dt, 1), 100);
        int d;
        for (d = 0; d < w->domain_count; d++) {
            n += w->domains[d].own + w->domains[d].cross;
            hits += w->domains[d].contacts;
        }
        slope = DEMI_MAX((n - hits)/w->bodies.count, 0.02)/w->margin.skin_auto;
        best = sqrt(40*per_step*looks/slope);
        best = DEMI_MIN(DEMI_MAX(best, 0.5*w->margin.skin_auto), 2*w->margin.skin_auto);
        w->margin.skin_auto = DEMI_MIN(DEMI_MAX(sqrt(best*w->margin.skin_auto), 0.01*r), 2*r);
    }
    for (k = 0; k < 3; k++) {  /* a period must hold two grains and the skin, twice */
        const double room = (double)demi_periods_of(w).period[k]/2*(1 - 1e-6) -
            2*(double)w->effects.radius_max;
        if (w->desc.boundary[k] == DEM_BOUNDARY_PERIODIC && room > 0)
            w->margin.skin_auto = DEMI_MIN(w->margin.skin_auto, room);
    }
    w->margin.skin = w->margin.skin_auto;
}

/* Does a function of the user's answer forces? */
static int demi_own(const dem_world *w) {
    return w->desc.law || w->desc.force || w->desc.body_force;
}
/* Do laws ask for spins in this scene? Does any body have one that matters? */
static int demi_spins(const dem_world *w) {
    return w->desc.law || w->desc.body_force || w->effects.tangent != DEM_TANGENT_NONE ||
           w->effects.rolling != DEM_ROLLING_NONE;
}
static int demi_turns(const dem_world *w) { return w->bodies.orienting || demi_spins(w); }

/* How many domains: of the number of bodies alone, so that bits do not depend on threads; 1, 2, 4,
   or a multiple of 8, which most numbers of threads share fairly. */
static int demi_domains_for(int count) {
    int n = 1;
    while (n < 8 && n*DEM_DOMAIN_BODIES < count) n *= 2;
    return n < 8 ? n : DEMI_MIN(DEMI_MAX(count/DEM_DOMAIN_BODIES/8*8, 8), (int)DEMI_DOMAINS);
}

/* A domain out of use: what it counted long ago must not steer the next lists. Contacts that last
   are still to be moved. */
static void demi_domain_forget(demi_domain *o) {
    const int kept = o->kept;
    memset(o, 0, sizeof *o);
    o->kept = kept;
}
/* Says that a body is nowhere: a run that blew up before, and was gone on with. */
static dem_result demi_lost(dem_world *w, int body) {
    const dem_real *x = w->bodies.pos + 4*body;
    return demi_fail(w, DEM_ERROR_UNSTABLE, "dem_world_step: step %llu, body %u: its position is "
                     "(%g, %g, %g) m, must be finite and at most %g m from the origin; the run "
                     "blew up before (two grains at one place, dt too large, or a law, field "
                     "or motion of your own that divides by zero): take the body out, or go back "
                     "to a checkpoint", (unsigned long long)w->clock.steps,
                     (unsigned)w->bodies.slot[body] + 1, (double)x[0], (double)x[1], (double)x[2],
                     DEMI_FARTHEST);
}
/* Bodies that lie on each other, or far from all others, share a cell, and a cell's bodies are all
   compared. 1 with a sentence when that would take minutes. */
static int demi_crowd_refuse(dem_world *w) {
    const int32_t *start = w->cell_start;
    const int n = w->cells[0]*w->cells[1]*w->cells[2];
    double work = 0;
    int c, crowd = 0;
    for (c = 0; c < n; c++) {
        const int here = start[c + 1] - start[c];
        work += (double)here*here;
        crowd = DEMI_MAX(crowd, here);
    }
    if (!demi_searches[w->desc.search].crowds || work <= 1e9 + 2e4*w->bodies.count) return 0;
    demi_fail(w, DEM_ERROR_ARGUMENT, "dem_world_step: a search would compare %.2g pairs: %d of %d "
              "bodies are in one cell of %.3g by %.3g by %.3g m; they lie on each other, or some "
              "are far from all others: take those out (an outflow boundary does), or spread the "
              "others", work, crowd, w->bodies.count, w->cell_size[0], w->cell_size[1],
              w->cell_size[2]);
    return 1;
}
/* A wall longer than the period does not repeat, and must be there for all that stands in the box;
   says so when one ends too near. */
static int demi_walls_end(dem_world *w, const char *call) {
    const demi_periods p = demi_periods_of(w);
    const dem_real need = w->effects.radius_max*DEM_R(0.999);
    int j, k;
    for (j = 0; j < w->wall_count; j++)
        for (k = 0; k < 3; k++) {
            const demi_wall *wall = &w->walls[j];
            const dem_real lo = p.lo[k], hi = lo + p.period[k];
            if (wall->kind == DEMI_WALL_NONE || wall->extent < 0 || wall->repeats[k] ||
                !(p.period[k] > 0) || !(w->bodies.count > 0) ||
                (wall->span_lo[k] <= lo - need && wall->span_hi[k] >= hi + need)) continue;
            demi_fail(w, DEM_ERROR_ARGUMENT, "%s: wall %d goes from %g to %g m along periodic axis "
                      "%d, which is longer than the period of %g m, so that it does not repeat; it "
                      "must reach %g m, the largest radius, beyond the faces at %g and %g m, or be "
                      "no longer than the period", call, j + 1,
                      (double)wall->span_lo[k], (double)wall->span_hi[k], k, (double)p.period[k],
                      (double)w->effects.radius_max, (double)lo, (double)hi);
            return 1;
        }
    return 0;
}
/* --- new spheres join the list, so that a steady feed does not have it made anew for every grain:
       the candidates of a newcomer are written behind those of the others. It belongs to the last
       domain. Whether there is room hangs on counts alone, not on what was allocated: runs that go
       on from a checkpoint must do the same. --- */
enum { DEMI_JOIN_MOST = 8192 };

/* Is there no room behind the candidates? 1: pairs inside, 2: pairs leading out, 4: walls. */
static int demi_join_lack(const dem_world *w) {
    const int last = w->domain_count - 1;
    int d, lack = 0;
    if (!w->join_room) return 0;
    if (w->domains[last].own + w->join_room > w->own.stride) lack = 1;
    for (d = 0; d < last; d++)
        if (w->domains[d].cross + w->join_room > w->cross.stride) lack |= 2;
    return lack | (w->domains[last].walls + w->join_room > w->wall_stride ? 4 : 0);
}
/* May a sphere join? Not when it would bring an effect in, nor beside bodies of other shapes. */
static int demi_join_possible(const dem_world *w, int material, dem_real radius) {
    if (!w->stage.list_valid || w->stage.pairs_changed || !w->bodies.count || w->bodies.shaped ||
        w->bodies.ghost) return 0;
    return demi_species_known(w, material, radius);
}
/* Could the two touch before the near list is made anew? As demi_near_pick asks. */
static int demi_join_near(const dem_world *w, const demi_periods *p, int a, int b) {
    const dem_vec3 x = demi_nearest(p, demi_sub(demi_at(w->bodies.pos + 4*b),
                                                demi_at(w->bodies.pos + 4*a)));
    const dem_vec3 u = demi_sub(demi_at(w->bodies.vel + 4*b), demi_at(w->bodies.vel + 4*a));
    return demi_length(x) < w->bodies.pos[4*a + 3] + w->bodies.pos[4*b + 3] +
           (dem_real)w->margin.slack +
                            (dem_real)w->margin.span*demi_length(u);
}
/* Body i, just appended, joins the list; `found`, ascending: all whose gap to it may be below the
   skin. 0: there was no room, the list must be made anew. */
static int demi_list_join(dem_world *w, int i, const int32_t *found, int count) {
    const int last = w->domain_count - 1, walls = w->domains[last].walls;
    const demi_periods p = demi_periods_of(w);
    int k, leading = 0;
    w->domains[last].end = i + 1;
    if (count >= w->join_room) return 0;
    w->join_room -= count;
    for (k = 0; k < count; k++) {
        const int a = found[k], d = demi_domain_of(w, a);
        demi_domain *domain = &w->domains[d];
        demi_list *list = d == last ? &w->own : &w->cross;
        const int at = d == last ? domain->own : domain->cross;
        list->place[d*list->stride + at] = 0;
        demi_pair_offer(w, d, &p, (dem_real)w->margin.skin, a, i);
        leading |= d < last;
        w->stage.near_stale |= demi_join_near(w, &p, a, i);
    }
    if (leading && !demi_cross_index(w)) return 0;
    demi_body_walls(w, last, i);
    if (w->domains[last].walls - walls >= w->join_room) return 0;
    w->join_room -= w->domains[last].walls - walls;
    if (w->domains[last].walls > walls) w->touching_valid = 0;
    if (!DEMI_GROW(w, w->quiet,
                   (size_t)(w->bodies.count/DEMI_SOME + w->domain_count + 1))) return 0;
    demi_quiet_at(w, last, i)->restless = 2;
    w->effects.radius_min = DEMI_MIN(w->effects.radius_min, w->bodies.pos[4*i + 3]);
    w->effects.radius_max = DEMI_MAX(w->effects.radius_max, w->bodies.pos[4*i + 3]);
    return 1;
}

/* What the laws of before kept, for those in force now: each law's reals go where it has them. */
static void demi_memory_map(const demi_laws *was, const demi_laws *now, const dem_real *old,
                            dem_real *m) {
    int k;
    for (k = 0; k < now->memory; k++) m[k] = 0;
    for (k = 0; k < now->tangent->memory && was->tangent == now->tangent; k++) m[k] = old[k];
    for (k = 0; k < now->rolling->memory && was->rolling == now->rolling; k++)
        m[now->at_rolling + k] = old[was->at_rolling + k];
    for (k = 0; k < now->normal->memory; k++) m[now->at_normal + k] = old[was->at_normal + k];
}
/* All memory on its way to the next list (there is none now). 0 when memory ran out; nothing
   changed then. */
static int demi_memory_move(dem_world *w, const demi_laws *was) {
    const size_t from = (size_t)w->filed.stride, to = (size_t)w->laws.memory;
    dem_real old[DEMI_MEMORY], *fresh = 0;
    int d, k;
    if (w->filed.stride != was->memory) w->filed.count = 0;    /* of no use: not these laws' */
    if (!DEMI_GROW(w, fresh, (size_t)w->filed.count*to)) return 0;
    for (k = 0; k < w->filed.count; k++)
        demi_memory_map(was, &w->laws, w->filed.memory + (size_t)k*from,
                        fresh + (size_t)k*to);
    demi_free(w, w->filed.memory);
    w->filed.memory = fresh;
    w->filed.stride = (int)to;
    for (d = 0; d < w->domain_count; d++) {
        for (k = 0; k < w->domains[d].kept; k++) {
            demi_kept *c = demi_kept_of(w, d) + k;
            memcpy(old, c->memory, sizeof old);
            memset(c->memory, 0, sizeof c->memory);
            demi_memory_map(was, &w->laws, old, c->memory);
        }
    }
    return 1;
}
/* The effects of the scene as it is now; when friction has come into it, or has gone, memory moves
   with the laws. 0 when memory ran out: the laws of before stay in force. */
static int demi_effects_take(dem_world *w) {
    const demi_laws was = w->laws;
    const int tangent = w->effects.tangent, rolling = w->effects.rolling;
    demi_effects(w);
    if (demi_species_room(w) && (w->desc.law || !was.normal ||
        (was.tangent == w->laws.tangent && was.rolling == w->laws.rolling) ||
        demi_memory_move(w, &was))) {
        demi_species_lay(w);
        demi_species_vary(w);
        return 1;
    }
    w->effects.tangent = tangent;
    w->effects.rolling = rolling;
    demi_effects_memory(w);
    return 0;
}
/* Answers 1 with a sentence when a period is too short for one image of each partner. */
static int demi_periods_refuse(dem_world *w) {
    const demi_periods p = demi_periods_of(w);
    const double need = 2*(2*(double)w->effects.radius_max + w->margin.skin);
    int k;
    for (k = 0; k < 3; k++)
        if (w->desc.boundary[k] == DEM_BOUNDARY_PERIODIC && (double)p.period[k] < need) {
            demi_fail(w, DEM_ERROR_ARGUMENT, "dem_world_step: the domain is %g m long on periodic "
                      "axis %d, must be at least %g m (two grains and the skin, twice); make it "
                      "longer or the grains smaller", (double)p.period[k], k, need);
            return 1;
        }
    return 0;
}
/* Deals the bodies, in the order of the sort, to domains. */
static void demi_domains_deal(dem_world *w) {
    int d;
    for (d = w->domain_count; d < DEMI_DOMAINS; d++) demi_domain_forget(&w->domains[d]);
    w->domain_count = demi_domains_for(w->bodies.count);
    for (d = 0; d < w->domain_count; d++) {
        w->domains[d].begin = (int)((int64_t)w->bodies.count*d/w->domain_count);
        w->domains[d].end = (int)((int64_t)w->bodies.count*(d + 1)/w->domain_count);
        w->domains[d].overflow = 0;
    }
}
/* Which of the lists in `lists` (1: own, 2: cross, 4: walls) some domain had too little room in. */
static int demi_lists_overflow(const dem_world *w, int lists) {
    int d, over = demi_join_lack(w);
    for (d = 0; d < w->domain_count; d++) over |= w->domains[d].overflow;
    return over & lists;
}
/* Neighbour lists of bodies: searched anew until every domain's pairs fit. 0: no memory. */
static int demi_pairs_find(dem_world *w) {
    const int n = w->domain_count, stride = DEMI_MAX(64, w->bodies.count/n*3);
    int over;
    if (demi_searches[w->desc.search].lay && !demi_searches[w->desc.search].lay(w)) return 0;
    w->join_room = w->feed_count ? DEMI_MIN(512 + w->bodies.count/16, DEMI_JOIN_MOST) : 0;
    if (!demi_list_reserve(w, &w->own, n, DEMI_MAX(stride, (int)w->own.stride)) ||
        !demi_list_reserve(w, &w->cross, n, n == 1 ? 0 : DEMI_MAX(stride/4, (int)w->cross.stride)))
        return 0;
    do {
        demi_parallel(w, w->desc.threads, n, demi_domain_search);
        over = demi_lists_overflow(w, 3);
        if ((over & 1 && !demi_list_reserve(w, &w->own, n, w->own.stride/2*3 + 64)) ||
            (over & 2 && !demi_list_reserve(w, &w->cross, n, w->cross.stride/2*3 + 64))) return 0;
    } while (over);
    return demi_cross_index(w);
}
/* Candidates on walls, likewise. */
static int demi_walls_find(dem_world *w) {
    int room = DEMI_MAX(w->wall_stride, 64);
    do {
        if (!demi_wall_lists_reserve(w, room)) return 0;
        demi_parallel(w, w->desc.threads, w->domain_count, demi_domain_walls);
        room = w->wall_stride/2*3 + 64;
    } while (demi_lists_overflow(w, 4));
    return 1;
}
/* Contacts that are kept move to the new lists: all room first, for what has moved cannot go
   back. */
static int demi_contacts_move(dem_world *w) {
    int first[DEMI_DOMAINS + 1];
    if (!demi_kept_room(w, first) || !demi_touching_reserve(w)) return 0;
    demi_kept_move(w, first);
    return 1;
}
/* Slots freed since the last list may be used again. */
static void demi_slots_release(dem_world *w) {
    while (w->bodies.slot_pending >= 0) {
        const int slot = w->bodies.slot_pending;
        w->bodies.slot_pending = -2 - w->bodies.slot_index[slot];
        w->bodies.slot_index[slot] = -2 - w->bodies.slot_free;
        w->bodies.slot_free = slot;
    }
}
/* Rebuilds everything the step needs to find contacts: first what may be refused, then bodies are
   put in order, then lists are made and memory moves to them. DEM_ERROR_MEMORY leaves bodies and
   memory as they were (the next call tries again). */
static dem_result demi_lists_make(dem_world *w, const char *call) {
    double least;
    int k;
    for (k = 0; k < w->bodies.count; k++)
        if (!demi_place(demi_at(w->bodies.pos + 4*k))) return demi_lost(w, k);
    if (!demi_list_drop(w) || !demi_effects_take(w)) return demi_no_memory(w, call);
    if (!w->stage.skin_chosen || w->bodies.ghost) demi_skin_choose(w);
    w->stage.skin_chosen = 1;
    if (demi_periods_refuse(w)) return DEM_ERROR_ARGUMENT;
    demi_walls_repeat(w);
    if (demi_walls_end(w, call)) return DEM_ERROR_ARGUMENT;
    demi_wrap(w);                               /* after what may be refused: places stay then */
    if (!w->facets_valid && !demi_facets_weigh(w)) return demi_no_memory(w, call);
    demi_levels_choose(w);
    least = 2*(w->levels.wide ? w->levels.fine : (double)w->effects.radius_max) + w->margin.skin;
    if (!demi_grid_lay(w, least + 1e-300)) return demi_no_memory(w, call);
    demi_bodies_sort(w);
    if (!w->levels.count && demi_crowd_refuse(w)) return DEM_ERROR_ARGUMENT;
    if ((w->bodies.shaped && !demi_centres_lay(w)) || (w->levels.count && !demi_levels_lay(w)))
        return demi_no_memory(w, call);
    demi_image_shifts(w);
    demi_domains_deal(w);
    if (!demi_pairs_find(w)) return demi_no_memory(w, call);
    if (!w->stage.near_chosen) demi_near_choose(w);
    w->stage.near_chosen = 1;
    if (!demi_near_make(w, 1) || !demi_walls_find(w) || !demi_contacts_move(w))
        return demi_no_memory(w, call);
    if (demi_quiet_possible(w))
        demi_parallel(w, w->desc.threads, w->domain_count, demi_domain_quiet);
    demi_slots_release(w);
    w->filed.count = 0;
    w->stage.skin_chosen = w->stage.near_chosen = 0;
    w->margin.gone = w->margin.walls_gone = 0;
    w->clock.last_rebuild = w->clock.steps;
    w->clock.rebuilds++;
    w->stage.list_valid = 1;
    return DEM_OK;
}
/* A rebuild that is refused leaves the domains of before: contacts still stand in those. */
static dem_result demi_rebuild(dem_world *w, const char *call) {
    const int domains = w->domain_count;
    const dem_result result = demi_lists_make(w, call);
    if (result != DEM_OK) w->domain_count = domains;    /* contacts still stand in those */
    return result;
}

/* Answers -1 with a sentence, for those who ask about a list that no longer fits. */
static int demi_list_stale(const dem_world *world, const char *call) {
    demi_fail((dem_world *)world, DEM_ERROR_ARGUMENT, "%s: there was no step since bodies or "
              "walls were added or changed, so there is no list of contacts; call dem_search_now "
              "or dem_world_step first", call);
    return -1;
}
DEM_API int dem_candidates_get(const dem_world *w, uint32_t *out, int capacity) {
    if (demi_null(w, "dem_candidates_get", w, "world")) return -1;
    int d, l, k, n = 0;
    if (!w->stage.list_valid) return demi_list_stale(w, "dem_candidates_get");
    for (d = 0; d < w->domain_count; d++)
        for (l = 0; l < 2; l++) {
            const demi_list *list = l ? &w->cross : &w->own;
            const int count = l ? w->domains[d].cross : w->domains[d].own;
            for (k = d*list->stride; k < d*list->stride + count; k++, n++) {
                if (n >= capacity || !out) continue;
                out[2*n] = w->bodies.slot[list->a[k]] + 1;
                out[2*n + 1] = w->bodies.slot[list->b[k]] + 1;
            }
        }
    return n;
}
DEM_API dem_result dem_search_now(dem_world *w) {
    if (demi_null(w, "dem_search_now", w, "world")) return DEM_ERROR_ARGUMENT;
    return demi_rebuild(w, "dem_search_now");
}

/* ---------------------------------------------------------------------------------------------
   >>touch
   Geometry only: where a sphere, and what else is put in its place, meets a wall element, and
   which of the elements it overlaps count. (Where two spheres meet is demi_tile_touch; which of
   them are near is known from the candidates.) Knows no law and no material, works in the wall's
   frame, and finds places: normal, point, overlap, share. A place that several facets name is
   one; those whose weights cancel are gone before a law is asked. Room for places was counted
   when the list was made.
   --------------------------------------------------------------------------------------------- */

/* --- surfaces of facets: which places are nearest, and how often each counts (>>facets) --- */

/* The point of a triangle (n = 3) or segment nearest the origin [ERI05] 5.1.5. *where: 0 inside,
   1 + k on the side from corner k to the next, 4 + k corner k. Rounding may put it on one side of a
   border or the other, which moves the point by no more than that. */
DEM_INLINE dem_vec3 demi_side_point(dem_vec3 a, dem_vec3 b, int k, int l, int *where) {
    const dem_vec3 ab = demi_sub(b, a);
    const dem_real t = -demi_dot(a, ab), ll = demi_dot(ab, ab);
    *where = t <= 0 ? 4 + k : t >= ll ? 4 + l : 1 + k;
    return t <= 0 ? a : t >= ll ? b : demi_add(a, demi_scale(ab, t/ll));
}
/* A triangle so thin that it has no plane: the nearest of its sides. */
static dem_vec3 demi_sides_point(const dem_vec3 *y, int *where) {
    dem_vec3 best = demi_side_point(y[0], y[1], 0, 1, where), d;
    int k, at;
    for (k = 1; k < 3; k++) {
        d = demi_side_point(y[k], y[(k + 1)%3], k, (k + 1)%3, &at);
        if (!(demi_dot(d, d) < demi_dot(best, best))) continue;
        best = d;
        *where = at;
    }
    return best;
}
/* Closest point of a segment (n = 2) or triangle (n = 3) to the origin [ERI05, 5.1.5]. where: 0:
   inside, 1 .. 3: on a side, 4 .. 6: at a corner. */
DEM_INLINE dem_vec3 demi_facet_point(const dem_vec3 *y, int n, int *where) {
    dem_vec3 ab, ac, normal;
    dem_real d1, d2, d3, d4, d5, d6, nn;
    if (n == 2) {
        const dem_vec3 p = demi_side_point(y[0], y[1], 0, 1, where);
        if (*where != 1) return p;
        *where = 0;                             /* in the plane: along the normal, exactly */
        ab = demi_sub(y[1], y[0]);
        if (y[0].z < 0 || y[0].z > 0 || ab.z < 0 || ab.z > 0) return p;
        normal = demi_v(-ab.y, ab.x, 0);
        return demi_scale(normal, demi_dot(normal, y[0])/demi_dot(ab, ab));
    }
    ab = demi_sub(y[1], y[0]);
    ac = demi_sub(y[2], y[0]);
    d1 = -demi_dot(ab, y[0]); d2 = -demi_dot(ac, y[0]);
    if (d1 <= 0 && d2 <= 0) { *where = 4; return y[0]; }
    d3 = -demi_dot(ab, y[1]); d4 = -demi_dot(ac, y[1]);
    if (d3 >= 0 && d4 <= d3) { *where = 5; return y[1]; }
    d5 = -demi_dot(ab, y[2]); d6 = -demi_dot(ac, y[2]);
    if (d6 >= 0 && d5 <= d6) { *where = 6; return y[2]; }
    if (d1*d4 - d3*d2 <= 0 && d1 >= 0 && d3 <= 0) return demi_side_point(y[0], y[1], 0, 1, where);
    if (d5*d2 - d1*d6 <= 0 && d2 >= 0 && d6 <= 0) return demi_side_point(y[2], y[0], 2, 0, where);
    if (d3*d6 - d5*d4 <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
        return demi_side_point(y[1], y[2], 1, 2, where);
    *where = 0;                                 /* along the normal, exact however large it is */
    normal = demi_cross(ab, ac);
    nn = demi_dot(normal, normal);
    if (!(nn > (DEMI_SINGLE ? DEM_R(1e-10) : DEM_R(1e-20))*demi_dot(ab, ab)*demi_dot(ac, ac)))
        return demi_sides_point(y, where);
    return demi_scale(normal, demi_dot(normal, y[0])/nn);
}

/* Places found so far for one body and one wall. `point` is from the body's centre, `overlap` is
   the distance; both in the body's own measure (an ellipsoid's is that in which it is the unit
   sphere). Few are looked through one by one, many by a table of their numbers. */
typedef struct demi_places {
    demi_touching *at;
    int32_t *table;                /* mask + 1 of them: 1 + index into at, 0: free; or null */
    uint32_t mask;
    int count, offset;             /* what numbers begin with: an image of the body each */
} demi_places;
/* One more facet says that place `number` is at d and counts so much: places add up. */
static void demi_places_add(demi_places *p, int32_t number, dem_real weight, dem_vec3 d,
                            dem_real d2) {
    uint32_t slot = (uint32_t)(number + p->offset)*UINT32_C(2654435769) & p->mask;
    int i = 0;
    number += p->offset;
    if (!p->table) while (i < p->count && p->at[i].element != number) i++;
    else {
        for (; p->table[slot]; slot = (slot + 1) & p->mask)
            if (p->at[p->table[slot] - 1].element == number) break;
        i = p->table[slot] ? p->table[slot] - 1 : p->count;
        p->table[slot] = i + 1;
    }
    if (i < p->count) { p->at[i].share += weight; return; }
    p->at[i].element = number;
    p->at[i].share = weight;
    p->at[i].point = d;
    p->at[i].overlap = DEMI_SQRT(d2);
    p->count++;
}
/* What is left: those that cancel go, those that are one place to the eye of rounding (a side and
   a cut of it) become one. */
static void demi_places_merge(demi_places *p, dem_real near_by) {
    int i, k, count = 0;
    for (i = 0; i < p->count; i++) {
        demi_touching t = p->at[i];
        if (t.share > DEM_R(-1e-3) && t.share < DEM_R(1e-3)) continue;
        for (k = 0; k < count; k++) {
            const dem_vec3 d = demi_sub(t.point, p->at[k].point);
            if (demi_dot(d, d) <= near_by*near_by) break;
        }
        if (k == count) { p->at[count++] = t; continue; }
        p->at[k].share += t.share;              /* the lower number: the same from step to step */
        p->at[k].element = DEMI_MIN(p->at[k].element, t.element);
    }
    for (i = k = 0; i < count; i++)
        if (p->at[i].share < DEM_R(-1e-3) || p->at[i].share > DEM_R(1e-3)) p->at[k++] = p->at[i];
    p->count = k;
}
/* A vector in the measure in which an ellipsoid is the unit sphere. */
DEM_INLINE dem_vec3 demi_in_measure(const demi_part *part, dem_vec3 v) {
    v = dem_quat_unrotate(part->q, v);
    return demi_v(v.x/part->axes.x, v.y/part->axes.y, v.z/part->axes.z);
}
/* Corners of an element as seen from a body at x: in the body's measure, where part is an
   ellipsoid. Segments go on along z without end: there only what is across z counts. */
DEM_INLINE int demi_facet_seen(const demi_wall *wall, int element, dem_vec3 x,
                               const demi_part *part, dem_vec3 *y) {
    const int n = demi_wall_corners(wall, element, y);
    int k;
    for (k = 0; k < n; k++) {
        y[k] = demi_sub(y[k], x);
        if (n == 2) y[k].z = 0;
        if (part) y[k] = demi_in_measure(part, y[k]);
    }
    if (n == 2 && part) {
        const dem_vec3 u = demi_unit(demi_in_measure(part, demi_v(0, 0, 1)));
        for (k = 0; k < 2; k++) y[k] = demi_sub(y[k], demi_scale(u, demi_dot(y[k], u)));
    }
    return n;
}
/* The number of an element's nearest place. */
DEM_INLINE int32_t demi_facet_number(const demi_wall *wall, int e, int n, int where) {
    const int edges = wall->element_count;
    return where == 0 ? e : where < 4 ? edges + wall->edges[3*e + where - 1]
        : edges + wall->edge_count + wall->corners[n*e + where - 4];
}
/* An element none of whose neighbours is within reach: no edge or corner is that counts. */
DEM_INLINE void demi_facet_alone(const demi_wall *wall, int e, dem_vec3 x, dem_real within,
                                 demi_places *p) {
    dem_vec3 y[3];
    int where;
    const int n = demi_facet_seen(wall, e, x, 0, y);
    const dem_vec3 d = demi_facet_point(y, n, &where);
    const dem_real d2 = demi_dot(d, d);
    if (d2 < within*within && wall->weight[e] > 0)
        demi_places_add(p, demi_facet_number(wall, e, n, where), wall->weight[e], d, d2);
}
/* Adds what element `e` and the edges and corners it looks after give, nearer than `within`. */
DEM_INLINE void demi_facet_places(const demi_wall *wall, int e, dem_vec3 x, const demi_part *part,
                                  dem_real within, demi_places *p) {
    const int edges = wall->element_count, corners = edges + wall->edge_count;
    const int own = wall->owns[e];
    const dem_real *weight = wall->weight, most = within*within;
    dem_vec3 y[3], d;
    dem_real add = weight[e], d2;
    int where, done = 0, n, k, at;
    n = demi_facet_seen(wall, e, x, part, y);
    d = demi_facet_point(y, n, &where);
    d2 = demi_dot(d, d);
    if (!(d2 < most)) return;                   /* nor are its edges nearer */
    if (where >= 1 && where <= 3 && own >> (where - 1) & 1) {
        add += weight[edges + wall->edges[3*e + where - 1]];       /* the same point */
        done = where;
    }
    if (add < 0 || add > 0)
        demi_places_add(p, demi_facet_number(wall, e, n, where), add, d, d2);
    for (k = 0; k < 3 && n == 3 && own & 7; k++) {
        const dem_real count = weight[edges + wall->edges[3*e + k]];
        if (!(own >> k & 1) || done == k + 1 || !(count < 0 || count > 0)) continue;
        d = demi_side_point(y[k], y[(k + 1)%3], k, (k + 1)%3, &at);
        d2 = demi_dot(d, d);
        if (d2 < most)
            demi_places_add(p, at < 4 ? edges + wall->edges[3*e + k]
                       : corners + wall->corners[3*e + at - 4], count, d, d2);
    }
    for (k = 0; k < n && own >> 3; k++) {
        const int32_t number = corners + wall->corners[n*e + k];
        if (!(own >> (3 + k) & 1) || !(weight[number] < 0 || weight[number] > 0)) continue;
        d2 = demi_dot(y[k], y[k]);
        if (d2 < most) demi_places_add(p, number, weight[number], y[k], d2);
    }
    if (!wall->cut_start) return;
    for (k = wall->cut_start[e]; k < wall->cut_start[e + 1]; k++) {
        const demi_cut *c = &wall->cuts[k];
        dem_vec3 a = demi_sub(c->a, x), b = demi_sub(c->b, x);
        if (!(c->weight < 0 || c->weight > 0)) continue;
        if (part) { a = demi_in_measure(part, a); b = demi_in_measure(part, b); }
        d = demi_side_point(a, b, 0, 1, &at);
        d2 = demi_dot(d, d);
        if (d2 < most) demi_places_add(p, at < 4 ? c->number : c->end[at - 4], c->weight, d, d2);
    }
}

/* --- rings. Where what a ball reaches of a surface closes to a ring, on the rim of a hole or in a
       funnel, Euler's number is 0 and nothing would push. A ring is one place, so there
           E = integral of pieces(s) dU = U(facets) - U(links of a forest)
       pieces: chi and the rings that are open; a forest: of the sides and corners that join facets,
       nearest first, those that join what was not joined yet (Kruskal's). With U1 the nearest's,
       X the energy by >>facets and P that by pieces, D = P - X >= 0 is what rings took away, and
           E = X + D h(D/U1),    h(q) = (3 - 2 t) t^2, t = 2 q - 1/2 within 0 .. 1
       A dimple that is reached to its tip is a ring that is all but closed: D is small, and E is
       X, smooth; an open ring counts as one piece, and which of its sides are nearest may change
       from one moment to the next, as on the medial line of a single wall. Energy is conserved in
       either. Rings through a seam of two walls are not seen. --- */
static int demi_link_compare(const void *x, const void *y) {
    const demi_link *a = (const demi_link *)x, *b = (const demi_link *)y;
    if (a->corner != b->corner) return a->corner < b->corner ? -1 : 1;
    if (a->number != b->number) return a->number < b->number ? -1 : 1;
    return a->facet < b->facet ? -1 : a->facet > b->facet;
}
static int demi_link_nearer(const void *x, const void *y) {
    const demi_link *a = (const demi_link *)x, *b = (const demi_link *)y;
    if (a->distance < b->distance) return -1;
    return a->distance > b->distance ? 1 : demi_link_compare(x, y);
}
static int demi_link_root(demi_link *link, int i) {
    while (link[i].root != i) i = link[i].root = link[link[i].root].root;
    return i;
}
/* Facets that are reached, and their nearest place. */
typedef struct demi_ring {
    int facets;
    int32_t number;
    dem_real distance;
    dem_vec3 point;
} demi_ring;
/* Adds a side (b: its other end) or corner of the facet under work, if it is reached: its numbers,
   and where it is nearest. From whichever facet, the same side gives the same, to the bit: a has
   the lower number. */
static int demi_link_add(demi_link *link, int count, int facet, dem_real within, int32_t number,
                         const dem_vec3 *a, const dem_vec3 *b, const int32_t *ends) {
    demi_link *to = &link[count];
    const int turn = b && ends[0] > ends[1];
    int where = 4;
    to->point = b ? demi_side_point(turn ? *b : *a, turn ? *a : *b, 0, 1, &where) : *a;
    to->distance = demi_length(to->point);
    if (!(to->distance < within)) return count;
    to->corner = !b;
    to->facet = facet;
    to->number = number;
    to->place = !b || where < 4 ? number : ends[turn ? 5 - where : where - 4];
    to->sides[0] = to->sides[1] = -1;
    return count + 1;
}
/* The number of the side of element e that begins or ends at a corner: of its cut there, if it is
   cut. */
static int32_t demi_link_side(const demi_wall *wall, int e, int side, int32_t corner) {
    int k = wall->cut_start ? wall->cut_start[e] : 0;
    for (; wall->cut_start && k < wall->cut_start[e + 1]; k++) {
        const demi_cut *c = &wall->cuts[k];
        if (c->side == side && (c->end[0] == corner || c->end[1] == corner)) return c->number;
    }
    return wall->element_count + wall->edges[3*e + side];
}
/* Pieces of element e's sides, and the corners of others between them; *sides: which sides those
   are. */
static int demi_links_cut(const demi_wall *wall, int e, dem_vec3 x, const demi_part *part,
                          dem_real within, demi_link *link, int count, int facet, int *sides) {
    int k, m, q;
    for (k = wall->cut_start[e]; k < wall->cut_start[e + 1]; k++) {
        const demi_cut *c = &wall->cuts[k];
        dem_vec3 end[2];
        end[0] = demi_sub(c->a, x);
        end[1] = demi_sub(c->b, x);
        for (q = 0; q < 2 && part; q++) end[q] = demi_in_measure(part, end[q]);
        *sides |= 1 << c->side;
        count = demi_link_add(link, count, facet, within, c->number, end, end + 1, c->end);
        for (q = 0; q < 2; q++)                 /* where the next piece goes on */
            for (m = k + 1; m < wall->cut_start[e + 1]; m++) {
                const demi_cut *o = &wall->cuts[m];
                const int before = count;
                if (o->side != c->side || (o->end[0] != c->end[q] && o->end[1] != c->end[q]))
                    continue;
                count = demi_link_add(link, count, facet, within, c->end[q], end + q, 0, 0);
                if (count == before) continue;
                link[before].sides[0] = c->number;
                link[before].sides[1] = o->number;
            }
    }
    return count;
}
/* Sides and corners of element e, if it is reached. Answers how many links there are then. */
static int demi_links_add(const demi_wall *wall, int e, dem_vec3 x, const demi_part *part,
                          dem_real within, demi_link *link, int count, demi_ring *ring) {
    const int edges = wall->element_count, corners = edges + wall->edge_count;
    const int32_t *v;
    dem_vec3 y[3], d;
    int k, n, where, cut = 0;
    dem_real l;
    if (!(wall->weight[e] > 0)) return count;
    n = demi_facet_seen(wall, e, x, part, y);
    v = wall->corners + n*e;
    d = demi_facet_point(y, n, &where);
    l = demi_length(d);
    if (!(l < within)) return count;
    if (!ring->facets || l < ring->distance) {
        ring->number = where == 0 ? e : where < 4 ? edges + wall->edges[3*e + where - 1]
            : corners + v[where - 4];
        ring->distance = l;
        ring->point = d;
    }
    if (wall->cut_start)
        count = demi_links_cut(wall, e, x, part, within, link, count, ring->facets, &cut);
    for (k = 0; k < n; k++) {
        const int b = (k + 1)%n, before = count;
        int32_t ends[2];
        ends[0] = corners + v[k];
        ends[1] = corners + v[b];
        count = demi_link_add(link, count, ring->facets, within, corners + v[k], y + k, 0, 0);
        if (count > before && n == 3) {
            link[before].sides[0] = demi_link_side(wall, e, k, corners + v[k]);
            link[before].sides[1] = demi_link_side(wall, e, (k + 2)%3, corners + v[k]);
        }
        if (n == 3 && !(cut >> k & 1))
            count = demi_link_add(link, count, ring->facets, within, edges + wall->edges[3*e + k],
                                  y + k, y + b, ends);
    }
    ring->facets++;
    return count;
}
/* chi's weight of a corner, from the facets at it that are links first .. end - 1: 1 + facets -
   sides (meshes), 1 - facets (profiles). */
static int demi_links_corner(const demi_link *link, int first, int end) {
    int i, k, j, sides = 0;
    if (link[first].sides[0] < 0) return 1 - (end - first);
    for (i = first; i < end; i++)
        for (k = 0; k < 2; k++) {
            int seen = 0;
            for (j = first; j < i && !seen; j++)
                seen = link[j].sides[0] == link[i].sides[k] || link[j].sides[1] == link[i].sides[k];
            sides += !seen;
        }
    return 1 + (end - first) - sides;
}
/* Corrects the places of one body and wall for open rings. power: of U in the overlap. */
static void demi_places_rings(const demi_wall *wall, const int32_t *element, int candidates,
                              dem_vec3 x, const demi_part *part, dem_real within, dem_real power,
                              demi_link *link, demi_places *p) {
    demi_ring ring;
    dem_real lost = 0, t, h, slope;
    int i, k, end, count = 0;
    memset(&ring, 0, sizeof ring);
    for (i = 0; i < candidates; i++)
        count = demi_links_add(wall, element[i], x, part, within, link, count, &ring);
    if (ring.facets < 2) return;
    qsort(link, (size_t)count, sizeof *link, demi_link_compare);
    for (i = 1; i < count; i++)                 /* one side, one distance, whatever the rounding */
        if (link[i].number == link[i - 1].number) link[i].distance = link[i - 1].distance;
    qsort(link, (size_t)count, sizeof *link, demi_link_nearer);
    for (i = 0; i < ring.facets; i++) link[i].root = i;
    for (i = 0; i < count; i = end) {
        const dem_real q = (within - link[i].distance)/(within - ring.distance);
        int joined = 0;
        for (end = i + 1; end < count && link[end].number == link[i].number; end++) {
            const int a = demi_link_root(link, link[i].facet);
            const int b = demi_link_root(link, link[end].facet);
            joined += a != b;
            link[DEMI_MAX(a, b)].root = DEMI_MIN(a, b);
        }
        k = link[i].corner ? -demi_links_corner(link, i, end) : end - i - 1;
        link[i].more = (dem_real)(k - joined);
        lost += link[i].more*(power > 2 ? q*q*DEMI_SQRT(q) : q*q);
        for (k = i + 1; k < end; k++) link[k].more = 0;
    }
    if (!(lost > DEM_R(0.25))) return;
    t = DEMI_MIN(2*lost - DEM_R(0.5), DEM_R(1));
    h = t*t*(3 - 2*t);
    slope = t < 1 ? 12*t*(1 - t) : 0;           /* dh/dq */
    for (i = 0; i < count; i++)
        if (link[i].more < 0 || link[i].more > 0)
            demi_places_add(p, link[i].place, link[i].more*(h + lost*slope), link[i].point,
                       link[i].distance*link[i].distance);
    demi_places_add(p, ring.number, -lost*lost*slope, ring.point, ring.distance*ring.distance);
}

/* --- sieves: a sphere against all of a sieve, in the sieve's frame: z across, a hole in the
       middle, wires and holes in rows along x and y. Only what is near is looked at, found from the
       sphere's place: the cost does not depend on how many holes there are.
         rows    wires, bars, and the strips between square holes or slots: convex, endless or cut
                 off by a disc. Rows of set 0 go along y, of set 1 along x
         round   plates with round holes: the face, or the nearest point of the rim and the one
                 across, so that a grain too large for the hole sits on it
         ring    plates and reduced holes cut out as a disc lie in a thin ring
       Where two rows cross, a grain that reaches both at one place reaches one thing. With d the
       distances of rows and those of what two rows share (their crossings), U(d) the energy of one
       contact and its overlap r - d,
           E = sum of U(rows) - sum of U(those crossings that join, nearest first, what was not
               joined yet)
       which is the sum over separate pieces of what is reached, as it grows (Kruskal's forest, as
       for rings of facets): never less than the nearest row's, and force is its gradient, so that
       energy is kept; a plate pushes as one however fine its holes. A crossing at a row's own
       nearest point takes that away: above a crossing there is one contact, half way between two
       rows, two. One that does not takes away by itself, as a contact of share -1.
       Every row, crossing and side has an element number of its own, for contact memory. Tests:
       tests/test_sieve.c, tests/hard/hard_impacts.c. --- */
enum { DEMI_SIEVE_FACE = 1 << 30, DEMI_SIEVE_RIM = DEMI_SIEVE_FACE + 1,
       DEMI_SIEVE_ROWS = 13 };                  /* rows of both sets, and the ring */
/* What the last three bits of a row's number say; of round holes, 0 .. 5: side, lattice. */
enum { DEMI_SIEVE_SET = 1, DEMI_SIEVE_ABOVE = 2, DEMI_SIEVE_CROSS = 4 };
typedef struct demi_sieve_row {
    int32_t number;
    int set, root;                 /* 2: the ring; of the forest */
    double i;                      /* which of its set */
    dem_real at, half;             /* m, its middle, and half its width (or diameter) */
    dem_real distance, edge;       /* m, of the sphere's centre; around foot */
    dem_vec3 foot;                 /* m, nearest point, or that of a wire's axis */
} demi_sieve_row;
/* Where rows a and b cross: nearest point and its distance, m. */
typedef struct demi_sieve_shared { dem_real distance; int a, b; dem_vec3 foot; } demi_sieve_shared;

/* Half of how thick it is. */
static dem_real demi_sieve_half(const dem_sieve_desc *s) {
    return s->kind == DEM_SIEVE_WIRES || s->kind == DEM_SIEVE_BARS ? (s->bar + s->lift)/2
        : s->thickness/2;
}
/* A number that tells rows and holes apart; far ones repeat, which does no harm. */
static int32_t demi_sieve_number(double i, double j, int side) {
    const int32_t a = (int32_t)(i - floor(i/16384)*16384), b = (int32_t)(j - floor(j/8192)*8192);
    return (int32_t)(((uint32_t)a << 16) | ((uint32_t)b << 3) | (uint32_t)side);
}
/* Adds the contact with what lies `edge` around foot, if there is one. */
static int demi_sieve_put(demi_touching *out, int count, int32_t element, dem_vec3 x,
                          dem_real r, dem_vec3 foot, dem_real edge) {
    const dem_vec3 d = demi_sub(foot, x);
    const dem_real l = demi_length(d), overlap = r + edge - l;
    demi_touching *c = &out[count];
    if (!(overlap > 0) || count == DEMI_SIEVE_MOST) return count;
    c->element = element;
    c->normal = l > 0 ? demi_scale(d, 1/l) : demi_v(0, 0, -1);
    c->point = demi_add(x, demi_scale(c->normal, l - edge));
    c->overlap = overlap;
    c->share = 1;
    return count + 1;
}
/* The sheet of a sieve as if it had no holes. */
static int demi_sieve_face(const dem_sieve_desc *s, dem_vec3 x, dem_real r,
                           demi_touching *out) {
    const dem_real up = x.z >= 0 ? DEM_R(1) : DEM_R(-1);
    out->element = DEMI_SIEVE_FACE;
    out->normal = demi_v(0, 0, -up);
    out->point = demi_v(x.x, x.y, up*s->thickness/2);
    out->overlap = r + s->thickness/2 - up*x.z;
    out->share = 1;
    return out->overlap > 0;
}
DEM_INLINE dem_real demi_clamp(dem_real x, dem_real lo, dem_real hi) {
    return x < lo ? lo : x > hi ? hi : x;
}
/* The point of a strip at - half .. at + half across u, cut off by a disc of radius R (0: not),
   that is nearest to (u, v). 0: there is none. */
static int demi_strip_point(dem_real at, dem_real half, dem_real R, dem_real *u, dem_real *v) {
    const dem_real x = *u, y = *v, lo = at - half, hi = at + half;
    const dem_real S = DEMI_SQRT(x*x + y*y), within = demi_clamp(x, lo, hi);
    dem_real best = -1;
    int k;
    *u = within;
    if (!(R > 0) || within*within + y*y <= R*R) return 1;
    *u = x*R/S; *v = y*R/S;                     /* the disc's, if the strip has it */
    if (S > R && *u >= lo && *u <= hi) return 1;
    for (k = 0; k < 2; k++) {                   /* a corner, where the strip's side ends */
        const dem_real side = k ? hi : lo, long2 = R*R - side*side;
        const dem_real end = long2 > 0 ? DEMI_SQRT(long2) : 0, to = demi_clamp(y, -end, end);
        const dem_real d2 = (side - x)*(side - x) + (to - y)*(to - y);
        if (!(long2 > 0) || (best >= 0 && d2 >= best)) continue;
        best = d2; *u = side; *v = to;
    }
    return best >= 0;
}
/* Which rows of one set a sphere reaches. */
static int demi_sieve_set(const dem_sieve_desc *s, int set, dem_vec3 x, dem_real r,
                          demi_sieve_row *row, int count) {
    const int wires = s->kind == DEM_SIEVE_WIRES || s->kind == DEM_SIEVE_BARS;
    const dem_real q = s->bar/2, h = !wires ? 0 : set ? -s->lift/2 : s->lift/2, R = s->radius;
    const dem_real hole = !set && s->kind == DEM_SIEVE_SLOTS ? s->length : s->aperture;
    const dem_real pitch = hole + s->bar, half = wires ? 0 : s->thickness/2;
    const dem_real u = set ? x.y : x.x, v = set ? x.x : x.y, S = DEMI_SQRT(x.x*x.x + x.y*x.y);
    const dem_real z = wires ? h : demi_clamp(x.z, -half, half);
    const dem_real far2 = (r + q)*(r + q) - (x.z - z)*(x.z - z);
    const double home = floor((double)((R > 0 && S > R ? u*R/S : u)/pitch));
    int k;
    if (!(far2 > 0) || !(hole > 0)) return count;
    for (k = -2; k <= 3; k++) {                 /* a grain far larger than holes lies on these */
        demi_sieve_row *one = &row[count];
        const dem_real at = (dem_real)(home + k + 0.5)*pitch, off = u - at;
        dem_real a = u, b = v;
        dem_vec3 d;
        if (off*off >= far2 + 2*q*(r + q) + q*q ||
            !demi_strip_point(at, wires ? DEM_R(0) : q, R, &a, &b)) continue;
        one->foot = set ? demi_v(b, a, z) : demi_v(a, b, z);
        d = demi_sub(one->foot, x);
        one->edge = wires ? q : 0;
        one->distance = demi_length(d) - one->edge;
        if (!(one->distance < r)) continue;
        one->set = set;
        one->i = home + k;
        one->at = at;
        one->half = q;
        one->number = demi_sieve_number(home + k, 0, set | (!wires && !(d.x < 0 || d.x > 0) &&
                                        !(d.y < 0 || d.y > 0) ? DEMI_SIEVE_ABOVE : 0));
        count++;
    }
    return count;
}
/* What two wires share, X^2 + (Z - h)^2 <= q^2 and Y^2 + (Z + h)^2 <= q^2: its point nearest to p,
   outside of both, where they meet. It is p drawn to both axes, by as much as puts it on either
   surface: Newton's method for these two. */
static dem_vec3 demi_wires_point(dem_vec3 p, dem_real q, dem_real h) {
    double m = sqrt((double)(p.x*p.x + (p.z - h)*(p.z - h)))/(double)q - 1;
    double n = sqrt((double)(p.y*p.y + (p.z + h)*(p.z + h)))/(double)q - 1;
    const double q2 = (double)q*(double)q, H = (double)h;
    double x = 0, y = 0, z = 0;
    int k;
    for (k = 0; k < 40; k++) {
        double sum, g, f, gm, gn, fn, det, dm, dn;
        sum = 1 + m + n;
        x = (double)p.x/(1 + m); y = (double)p.y/(1 + n);
        z = ((double)p.z + (m - n)*H)/sum;
        g = x*x + (z - H)*(z - H) - q2;
        f = y*y + (z + H)*(z + H) - q2;
        if (fabs(g) + fabs(f) < (DEMI_SINGLE ? 1e-12 : 4e-16)*q2) break;
        gm = -2*(x*x/(1 + m) + (z - H)*(z - H)/sum);
        fn = -2*(y*y/(1 + n) + (z + H)*(z + H)/sum);
        gn = -2*(z - H)*(z + H)/sum;
        det = gm*fn - gn*gn;
        if (!(det > 0)) break;
        dm = (-g*fn + f*gn)/det;
        dn = (-f*gm + g*gn)/det;
        m = m + dm > m/4 ? m + dm : m/4;
        n = n + dn > n/4 ? n + dn : n/4;
    }
    return demi_v((dem_real)x, (dem_real)y, (dem_real)z);
}
/* The nearest point of what rows a and b share (a of set 0 or 1, b of a later one). Answers 2 when
   it is a's own nearest point, 3 when b's, else 1; 0: they share nothing. */
static int demi_sieve_crossing(const dem_sieve_desc *s, const demi_sieve_row *a,
                               const demi_sieve_row *b, dem_vec3 x, dem_vec3 *foot) {
    const dem_real R = s->radius, half = s->thickness/2;
    const dem_real u = a->set ? x.y : x.x, v = a->set ? x.x : x.y;
    dem_real S, best = -1;
    int k;
    if (a->set == b->set) return 0;
    if (b->set == 2) {                          /* the ring, between the strip's sides */
        foot->z = demi_clamp(x.z, -half, half);
        S = DEMI_SQRT(u*u + v*v);
        for (k = 0; k < 5; k++) {
            const dem_real p = k == 4 ? u*R/S : a->at + (k & 1 ? a->half : -a->half);
            const dem_real far = R*R - p*p;
            const dem_real w = k == 4 ? v*R/S : !(far > 0) ? 0 : k & 2 ? DEMI_SQRT(far)
                : -DEMI_SQRT(far);
            const dem_real d2 = (p - u)*(p - u) + (w - v)*(w - v);
            if (k == 4 ? DEMI_ABS(p - a->at) > a->half : !(far > 0)) continue;
            if (best >= 0 && d2 >= best) continue;
            best = d2;
            foot->x = a->set ? w : p;
            foot->y = a->set ? p : w;
        }
        return best >= 0;
    }
    if (R > 0 && a->at*a->at + b->at*b->at >= R*R) return 0;
    if (s->kind == DEM_SIEVE_WIRES) {
        const dem_real q = s->bar/2, h = s->lift/2;
        const dem_vec3 at = demi_v(a->at, b->at, 0), p = demi_sub(x, at);
        const dem_vec3 f = demi_sub(demi_add(x, demi_scale(demi_sub(a->foot, x), a->distance/
                              (a->distance + q))), at);      /* on a, is it in b, too? */
        const dem_vec3 g = demi_sub(demi_add(x, demi_scale(demi_sub(b->foot, x), b->distance/
                              (b->distance + q))), at);
        const int in_b = f.y*f.y + (f.z + h)*(f.z + h) <= q*q;
        const int in_a = g.x*g.x + (g.z - h)*(g.z - h) <= q*q;
        if (h >= q) return 0;
        *foot = demi_add(at, in_b ? f : in_a ? g : demi_wires_point(p, q, h));
        return in_b ? 2 : in_a ? 3 : 1;
    }
    *foot = demi_v(demi_clamp(x.x, a->at - a->half, a->at + a->half),
                   demi_clamp(x.y, b->at - b->half, b->at + b->half),
                   demi_clamp(x.z, -half, half));
    return 1;
}
static int demi_sieve_root(demi_sieve_row *row, int i) {
    while (row[i].root != i) i = row[i].root;
    return i;
}
/* Contacts with rows, less their crossings, as above. */
static int demi_sieve_rows(const dem_sieve_desc *s, dem_vec3 x, dem_real r, demi_touching *out) {
    demi_sieve_row row[DEMI_SIEVE_ROWS];
    demi_sieve_shared all[DEMI_SIEVE_ROWS*DEMI_SIEVE_ROWS/2];
    const dem_real half = s->thickness/2, S = DEMI_SQRT(x.x*x.x + x.y*x.y);
    int rows = demi_sieve_set(s, 0, x, r, row, 0), i, k, crossings = 0, count = 0;
    if (s->kind != DEM_SIEVE_BARS) rows = demi_sieve_set(s, 1, x, r, row, rows);
    if (s->kind != DEM_SIEVE_BARS && s->kind != DEM_SIEVE_WIRES && s->radius > 0 && S > 0) {
        demi_sieve_row *ring = &row[rows];
        memset(ring, 0, sizeof *ring);
        ring->foot = demi_v(x.x*s->radius/S, x.y*s->radius/S, demi_clamp(x.z, -half, half));
        ring->distance = demi_length(demi_sub(ring->foot, x));
        ring->set = 2;
        ring->number = DEMI_SIEVE_RIM;
        rows += ring->distance < r;
    }
    for (i = 0; i < rows; i++) {
        row[i].root = i;
        for (k = 0; k < i; k++) {
            demi_sieve_shared one;
            const int how = demi_sieve_crossing(s, &row[k], &row[i], x, &one.foot);
            one.a = k; one.b = i;
            if (!how) continue;
            one.distance = how == 1 ? demi_length(demi_sub(one.foot, x))
                : row[how == 2 ? k : i].distance;
            if (!(one.distance < r)) continue;
            all[crossings++] = one;
        }
    }
    for (; crossings > 0; all[i] = all[--crossings]) {    /* nearest first */
        int a, b, at;
        for (i = 0, k = 1; k < crossings; k++) if (all[k].distance < all[i].distance) i = k;
        a = demi_sieve_root(row, all[i].a);
        b = demi_sieve_root(row, all[i].b);
        if (a == b) continue;
        row[DEMI_MAX(a, b)].root = DEMI_MIN(a, b);
        a = all[i].a; b = all[i].b;
        at = row[a].distance > row[b].distance ? a : b;
        if (all[i].distance <= row[at].distance && !(row[at].edge < 0))
            row[at].edge = -1;                  /* the row's own nearest point: they cancel */
        else {
            k = count;
            count = demi_sieve_put(out, count, row[b].set == 2 ? DEMI_SIEVE_RIM + 1 :
                                   demi_sieve_number(row[a].i, row[b].i, DEMI_SIEVE_CROSS), x, r,
                                   all[i].foot, 0);
            if (count > k) out[k].share = -1;
        }
    }
    for (i = 0; i < rows; i++) {
        if (row[i].edge < 0) continue;
        if (!(row[i].distance > 0) && half > 0 && s->kind != DEM_SIEVE_WIRES &&
            s->kind != DEM_SIEVE_BARS) {        /* within the plate: out by the nearer face */
            count += demi_sieve_face(s, x, r, out + count);
            out[count - 1].element = row[i].number;
        } else count = demi_sieve_put(out, count, row[i].number, x, r, row[i].foot, row[i].edge);
    }
    return count;
}
/* A plate with round holes: the hole that the centre is over, and of its rim the nearest place and
   the one across. Over a bar: the sheet. */
static int demi_sieve_round(const dem_sieve_desc *s, dem_vec3 x, dem_real r, demi_touching *out) {
    const dem_real half = s->thickness/2, z = demi_clamp(x.z, -half, half);
    const dem_real a = s->aperture/2, R = s->radius, S = DEMI_SQRT(x.x*x.x + x.y*x.y);
    const dem_real pitch = s->aperture + s->bar;
    const dem_real rows = s->staggered ? pitch*DEM_R(1.7320508075688772) : pitch;
    dem_real best = -1, l;
    dem_vec3 way, centre = x, to;
    int32_t number = 0;
    int k, side, count = 0;
    if (R > 0 && S > 0 && S > R - r)
        count = demi_sieve_put(out, 0, DEMI_SIEVE_RIM, x, r, demi_v(x.x*R/S, x.y*R/S, z), 0);
    if (R > 0 && S > R) return count;           /* off the disc */
    for (k = 0; k < 1 + (s->staggered != 0); k++) {    /* the nearest hole of either lattice */
        const dem_real shift = k ? DEM_R(0.5) : DEM_R(0);
        const double ix = floor((double)(x.x/pitch - shift) + 0.5);
        const double iy = floor((double)(x.y/rows - shift) + 0.5);
        const dem_vec3 c = demi_v(((dem_real)ix + shift)*pitch, ((dem_real)iy + shift)*rows, 0);
        l = (x.x - c.x)*(x.x - c.x) + (x.y - c.y)*(x.y - c.y);
        if (best >= 0 && l >= best) continue;
        best = l;
        centre = c;
        number = demi_sieve_number(ix, iy, 4*k);
    }
    if (best >= a*a) return demi_sieve_face(s, x, r, out);
    l = DEMI_SQRT(best);
    way = l > 0 ? demi_v((x.x - centre.x)/l, (x.y - centre.y)/l, 0) : demi_v(1, 0, 0);
    for (side = 0; side < 2; side++) {          /* nearest, and across */
        to = demi_add(demi_v(centre.x, centre.y, z), demi_scale(way, side ? -a : a));
        if (R > 0 && to.x*to.x + to.y*to.y > R*R) continue;
        count = demi_sieve_put(out, count, number + side, x, r, to, 0);
    }
    return count;
}
/* Contacts that are in truth one, where rims meet: each counts as far as its point
   stands out of the plane that touches at the other, towards the grain. L_a: how far a's point
   stands out of b's plane.
       share_a = max(L_a/(L_a + L_b), min(1, L_a/overlap_a))
   Half way between the two each bears half, and where L is far more than the overlap, each bears
   all: no jump on the way. */
static void demi_sieve_share(demi_touching *c, int count) {
    int a, b;
    for (a = 0; a < count; a++)
        for (b = a + 1; b < count; b++) {
            const dem_vec3 d = demi_sub(c[b].point, c[a].point);
            dem_real la = demi_dot(c[b].normal, d), lb = -demi_dot(c[a].normal, d), sa, sb;
            la = la > 0 ? la : 0;
            lb = lb > 0 ? lb : 0;
            sa = la + lb > 0 ? la/(la + lb) : 1;
            sb = 1 - sa;
            la /= c[a].overlap;
            lb /= c[b].overlap;
            c[a].share *= DEMI_MAX(sa, DEMI_MIN(la, DEM_R(1)));
            c[b].share *= DEMI_MAX(sb, DEMI_MIN(lb, DEM_R(1)));
        }
}
/* [ALK07] eq 4.20 to 4.25: 1 when a grain over (x, y) falls through. Half a hole is w, the reduced
   one w - b, b = zeta (w - r) or zeta w; model 1 wants the grain's edge within, model 2 its centre
   and r < w. [ALK07] leaves open what "c_x" does for grains that fit in no hole: here they never
   fall. */
static int demi_sieve_passes(const dem_sieve_desc *s, dem_vec3 x, dem_real r) {
    const dem_real w = s->aperture/2, pitch = s->aperture + s->bar;
    const dem_real room = (1 - s->clearance)*(s->model == 2 ? w : w - r);
    const dem_real u = x.x - (dem_real)floor((double)(x.x/pitch) + 0.5)*pitch;
    const dem_real v = x.y - (dem_real)floor((double)(x.y/pitch) + 0.5)*pitch;
    return r < w && DEMI_ABS(u) < room && DEMI_ABS(v) < room;
}
/* All contacts of a sphere at x of radius r with a sieve: at most DEMI_SIEVE_MOST; body and wall
   are the caller's to fill in. One of share 0 pushes nobody: a grain under way through a reduced
   hole. */
static int demi_sieve_touch(const dem_sieve_desc *s, dem_vec3 x, dem_real r,
                            demi_touching *out) {
    const dem_real S = DEMI_SQRT(x.x*x.x + x.y*x.y);
    int count = 0;
    switch (s->kind) {
    case DEM_SIEVE_REDUCED:
        if (s->radius > 0 && S > s->radius)
            return demi_sieve_put(out, 0, DEMI_SIEVE_RIM, x, r,
                                  demi_v(x.x*s->radius/S, x.y*s->radius/S, 0), 0);
        count = demi_sieve_face(s, x, r, out);
        if (count && demi_sieve_passes(s, x, r)) out->share = 0;
        return count;
    case DEM_SIEVE_ROUND:
        count = demi_sieve_round(s, x, r, out);
        if (count > 1) demi_sieve_share(out, count);
        break;
    default: count = demi_sieve_rows(s, x, r, out);
    }
    return count;
}

/* --- one sphere against one element, all in the wall's frame: fills in normal (grain -> wall) and
       point, answers the overlap (negative: apart). Candidates are told by it, too. --- */
typedef dem_real (*demi_near_fn)(const demi_wall *wall, int element, dem_vec3 x, dem_real r,
                                 dem_vec3 *normal, dem_vec3 *point);
/* z = 0 of the wall's frame, grains above. */
DEM_INLINE dem_real demi_plane_near(const demi_wall *wall, int element, dem_vec3 x, dem_real r,
                                dem_vec3 *normal, dem_vec3 *point) {
    (void)wall; (void)element;
    *normal = demi_v(0, 0, -1);
    *point = demi_v(x.x, x.y, 0);
    return r - x.z;
}
/* About z; a grain on the axis is pushed along x, for want of anything better. */
DEM_INLINE dem_real demi_cylinder_near(const demi_wall *wall, int element, dem_vec3 x, dem_real r,
                                   dem_vec3 *normal, dem_vec3 *point) {
    const dem_real l = DEMI_SQRT(x.x*x.x + x.y*x.y);
    const dem_vec3 d = l > 0 ? demi_v(x.x/l, x.y/l, 0) : demi_v(1, 0, 0);
    (void)element;
    *point = demi_v(d.x*wall->radius, d.y*wall->radius, x.z);
    *normal = wall->inside ? d : demi_scale(d, -1);
    return wall->inside ? r + l - wall->radius : r + wall->radius - l;
}
/* The sheet that a sieve lies in, holes or not. */
static dem_real demi_sieve_near(const demi_wall *wall, int element, dem_vec3 x, dem_real r,
                                dem_vec3 *normal, dem_vec3 *point) {
    dem_real l = DEMI_ABS(x.z) - demi_sieve_half(&wall->sieve);
    (void)element;
    if (wall->radius > 0)                       /* ends of wires stand out of it */
        l = DEMI_MAX(l, DEMI_SQRT(x.x*x.x + x.y*x.y) - wall->radius - wall->sieve.bar/2);
    *normal = demi_v(0, 0, x.z > 0 ? DEM_R(-1) : DEM_R(1));
    *point = demi_v(x.x, x.y, 0);
    return r - l;
}
/* A place `d` away that a ball of radius `reach`, the grain's own included, may touch. */
DEM_INLINE dem_real demi_point_near(dem_vec3 d, dem_real reach, dem_vec3 *normal) {
    const dem_real l = demi_length(d);
    *normal = l > 0 ? demi_scale(d, 1/l) : demi_v(0, 0, -1);
    return reach - l;
}
static dem_real demi_facet_distance(const demi_wall *wall, int element, dem_vec3 x, dem_real r,
                                    dem_vec3 *normal, dem_vec3 *point) {
    dem_vec3 c[3], d;
    int where;
    d = demi_facet_point(c, demi_facet_seen(wall, element, x, 0, c), &where);
    *point = demi_add(x, d);
    return demi_point_near(d, r, normal);
}
static dem_real demi_grain_near(const demi_wall *wall, int element, dem_vec3 x, dem_real r,
                                dem_vec3 *normal, dem_vec3 *point) {
    *point = demi_at(wall->vertices + 3*element);
    return demi_point_near(demi_sub(*point, x), r + wall->radius, normal);
}
#define DEMI_WALL_NEAR(KIND, C, M, T, N, NEAR, TOUCH, BEND) NEAR,
static const demi_near_fn demi_nears[] = {0, DEMI_WALLS(DEMI_WALL_NEAR)};

/* Distance from a point to an element; `enough` or more is not worked out: a triangle whose plane
   is too far off is dropped at once. */
static dem_real demi_wall_distance(const demi_wall *wall, int element, dem_vec3 local,
                                   dem_real enough) {
    dem_vec3 n, p;
    if (demi_wall_per(wall) == 3) {
        dem_vec3 c[3];
        dem_real h;
        demi_wall_corners(wall, element, c);
        n = demi_cross(demi_sub(c[1], c[0]), demi_sub(c[2], c[0]));
        h = demi_dot(n, demi_sub(local, c[0]));
        if (h*h >= enough*enough*demi_dot(n, n) && demi_dot(n, n) > 0) return enough;
    }
    return -demi_nears[wall->kind](wall, element, local, 0, &n, &p);
}

/* [MIL] Fig 5.19: the segment acts as its whole line, with the fraction a^2(3-2a) of the force, a =
   share of the chord that the segment covers. */
static dem_real demi_segment_share(const demi_wall *wall, int element, dem_vec3 x, dem_real r,
                                   dem_vec3 *normal,
                                   dem_vec3 *point, dem_real *overlap) {
    dem_vec3 c[2], t, n;
    dem_real length, off, along, chord, lo, hi, a;
    demi_wall_corners(wall, element, c);
    t = demi_sub(c[1], c[0]);
    length = demi_length(t);
    if (!(length > 0)) return 0;
    t = demi_scale(t, 1/length);
    n = demi_v(-t.y, t.x, 0);
    x.z = 0;
    off = demi_dot(demi_sub(x, c[0]), n);       /* signed distance from the line */
    along = demi_dot(demi_sub(x, c[0]), t);
    if (DEMI_ABS(off) >= r) return 0;
    chord = DEMI_SQRT(r*r - off*off);
    lo = DEMI_MAX(along - chord, DEM_R(0));
    hi = DEMI_MIN(along + chord, length);
    if (hi <= lo) return 0;
    a = (hi - lo)/(2*chord);
    *normal = off > 0 ? demi_scale(n, -1) : n;
    *point = demi_add(c[0], demi_scale(t, along));
    *overlap = r - DEMI_ABS(off);
    return a*a*(3 - 2*a);
}

#if defined(__GNUC__) && !defined(__clang__) && !defined(__TINYC__)
#pragma GCC push_options
#pragma GCC optimize("no-trapping-math")
#endif
/* ---------------------------------------------------------------------------------------------
   >>respond
   The loops that bring near pairs, touch and law together. Grain-grain, a tile of pairs at a
   time: what the law needs of the two bodies is copied into rows, pair after pair (a copy of three
   numbers that lie together is cheaper than three gathers); then stages run over the rows, one
   after the other: touch, motion, normal law, friction, rolling, answer (vectorised: groups of a
   constant length, which compilers turn into vectors at -O2 too); pushes are added to both bodies.
   A scene runs the stages that it calls for, so that any combination of laws costs the sum of its
   parts; the commonest ones have a stage for all of it, which saves the rows in between. Pairs that
   lead out of a domain leave that force in a slot of its own; the other domain fetches it after all
   are done, in the order of the list. So every body's sum has one order whatever the number of
   threads.
   --------------------------------------------------------------------------------------------- */
/* Pairs under work. Sums and differences are of the two bodies, a plus b and a minus b. A row has
   room to spare so that rows do not lie a power of two apart, which caches take badly. */
enum { DEMI_ROW = DEMI_TILE + 16 };
/* What is copied one by one. For gcc with x and y side by side, which one instruction moves (5 % of
   a step in single precision, 2 in double); clang takes such rows apart badly. */
#if defined(__GNUC__) && !defined(__clang__)
typedef struct demi_rows { dem_real xy[DEMI_ROW][2], z[DEMI_ROW]; } demi_rows;
#define DEMI_XY(rows, e, q) (rows)->xy[q][e]
#else
typedef struct demi_rows { dem_real xy[2][DEMI_ROW], z[DEMI_ROW]; } demi_rows;
#define DEMI_XY(rows, e, q) (rows)->xy[e][q]
#endif
typedef struct demi_tile {
    /* fetched */
    demi_rows gap;                 /* m, from a to b */
    demi_rows rate, gone;          /* m/s, difference of velocities: now, over the last step */
    demi_rows around, turned;      /* rad/s, sum of spins: the same */
    demi_rows apart, parted;       /* rad/s, difference of spins: the same */
    dem_real radius[2][DEMI_ROW];
    dem_real memory[DEMI_MEMORY][DEMI_ROW], coef[DEMI_PAIR_COLUMNS][DEMI_ROW];
    /* touch and motion */
    dem_real length[DEMI_ROW], over_d[DEMI_ROW], overlap[DEMI_ROW], deep[DEMI_ROW];
    dem_real touch[DEMI_ROW];      /* 1 where the two touch, else 0 */
    dem_real normal[3][DEMI_ROW], turn[3][DEMI_ROW];      /* unit, 1/s */
    dem_real slip[3][DEMI_ROW], slip_step[3][DEMI_ROW];   /* m/s */
    dem_real lean[DEMI_ROW];       /* m, from the middle to the contact, towards b */
    dem_real closing[DEMI_ROW], twist[DEMI_ROW];
    /* laws: what each leaves for the next (see dem_contact_force), what does not touch included */
    dem_real repulsion[DEMI_ROW], load[DEMI_ROW], slope[2][DEMI_ROW], kt[2][DEMI_ROW];
    dem_real ct[DEMI_ROW], tangent[3][DEMI_ROW], moment[3][DEMI_ROW];
    dem_real part[6][DEMI_ROW];                           /* energies */
    /* answer */
    dem_real force[3][DEMI_ROW], torque[2][3][DEMI_ROW];  /* torque on a, on b */
    /* the last, so that rows begin on cache lines (3 % of a step) */
    int row;                       /* of species_coef: all of coef holds it; -1: no row does */
} demi_tile;
/* Where the pairs of a tile stand in the near list. */
typedef struct demi_span {
    const int32_t *a, *b;
    const unsigned char *image;
    dem_real *memory;              /* column e of pair q: memory[e*stride + q] */
    const int32_t *row;            /* of the table of species, or null: */
    const dem_real *coef;          /* columns likewise; neither where all are alike */
    size_t stride;
    int count;
} demi_span;
/* Where `count` near pairs of domain d, from entry p on, have their numbers. */
static demi_span demi_span_of(const dem_world *w, int d, int p, int count) {
    const demi_near *near = &w->near;
    const size_t stride = (size_t)near->stride, at = (size_t)d*stride + (size_t)p;
    demi_span s;
    s.a = near->a + at;
    s.b = near->b + at;
    s.image = near->image + at;
    s.memory = near->memory ? near->memory + (size_t)d*(size_t)w->memory_stride*stride + p : 0;
    s.row = w->effects.uniform || demi_many_species(w) ? 0 : near->row + at;
    s.coef = demi_many_species(w) ? near->coef + (size_t)d*DEMI_PAIR_COLUMNS*stride + p : 0;
    s.stride = stride;
    s.count = count;
    return s;
}

/* Coefficients of pair q. */
static void demi_span_coefs(const dem_world *w, const demi_span *s, int q, dem_real *coef) {
    const int row = s->row ? s->row[q] : 0;
    int e;
    for (e = 0; e < DEMI_PAIR_COLUMNS; e++)
        coef[e] = s->coef ? s->coef[(size_t)e*s->stride + (size_t)q]
            : w->species_coef[DEMI_PAIR_COLUMNS*row + e];
}

DEM_INLINE dem_vec3 demi_row(dem_real rows[3][DEMI_ROW], int q) {
    return demi_v(rows[0][q], rows[1][q], rows[2][q]);
}
DEM_INLINE void demi_row_put(dem_real rows[3][DEMI_ROW], int q, dem_vec3 v) {
    rows[0][q] = v.x; rows[1][q] = v.y; rows[2][q] = v.z;
}
/* count: whole groups */
static void demi_row_copy(dem_real *DEMI_RESTRICT to, const dem_real *DEMI_RESTRICT from,
                          int count) {
    int q, l;
    for (q = 0; q < count; q += DEMI_LANES)
        for (l = 0; l < DEMI_LANES; l++) to[q + l] = from[q + l];
}
/* Rows of a tile are filled from bodies here and below: a - b, a + b, a - b + shift. */
DEM_INLINE void demi_rows_minus(demi_rows *DEMI_RESTRICT rows, size_t q, const dem_real *a,
                                const dem_real *b) {
    const dem_real x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    DEMI_XY(rows, 0, q) = x;
    DEMI_XY(rows, 1, q) = y;
    rows->z[q] = z;
}
DEM_INLINE void demi_rows_plus(demi_rows *DEMI_RESTRICT rows, size_t q, const dem_real *a,
                               const dem_real *b) {
    const dem_real x = a[0] + b[0], y = a[1] + b[1], z = a[2] + b[2];
    DEMI_XY(rows, 0, q) = x;
    DEMI_XY(rows, 1, q) = y;
    rows->z[q] = z;
}
DEM_INLINE void demi_rows_shifted(demi_rows *DEMI_RESTRICT rows, size_t q, const dem_real *a,
                                  const dem_real *b, const dem_real *shift) {
    const dem_real x = a[0] - b[0] + shift[0], y = a[1] - b[1] + shift[1];
    const dem_real z = a[2] - b[2] + shift[2];
    DEMI_XY(rows, 0, q) = x;
    DEMI_XY(rows, 1, q) = y;
    rows->z[q] = z;
}
DEM_INLINE dem_vec3 demi_rows_at(const demi_rows *rows, int q) {
    return demi_v(DEMI_XY(rows, 0, q), DEMI_XY(rows, 1, q), rows->z[q]);
}

/* What is the same for all pairs of a run: a stage takes a copy, so that compilers see that nothing
   changes it. */
typedef struct demi_same {
    dem_real dt, radius, inv_radius;
    int tension, friction_load, slider;
    int at_rolling, at_normal;     /* where their memory begins */
} demi_same;
/* What a scene calls for. */
typedef struct demi_run demi_run;
typedef void (*demi_stage)(demi_tile *DEMI_RESTRICT t, const demi_run *r, int full);
enum { DEMI_STAGES = 6 };
struct demi_run {
    const dem_world *w;
    const demi_span *span;         /* the pairs under work */
    int alike, ledger, keep;       /* are the two of a pair alike? keep: reals of memory */
    int turning, parting;          /* are spins, differences of spins wanted? */
    int following;                 /* is the motion over the last step wanted? */
    demi_same same;
    demi_stage stage[DEMI_STAGES]; /* in this order; null: the end */
};

/* Copies what the stages will see of the bodies into the rows. */
DEM_INLINE void demi_fetch(const demi_run *r, int count, demi_tile *DEMI_RESTRICT t, int uniform,
                           int turning, int parting, int following) {
    const dem_world *w = r->w;
    const dem_real *DEMI_RESTRICT x = w->bodies.pos, *DEMI_RESTRICT shift = w->image_shift;
    const dem_real *DEMI_RESTRICT u = w->bodies.vel, *DEMI_RESTRICT s = w->bodies.spin;
    const dem_real *DEMI_RESTRICT uh = w->bodies.half_vel, *DEMI_RESTRICT sh = w->bodies.half_spin;
    const int32_t *DEMI_RESTRICT la = r->span->a, *DEMI_RESTRICT lb = r->span->b;
    const unsigned char *DEMI_RESTRICT image = r->span->image;
    int n;
    for (n = 0; n < count; n++) {
        size_t q = (size_t)n;
        const dem_real *a, *b, *c;
        uint32_t i, j;
        DEMI_ONE_BY_ONE(q);
        i = (uint32_t)la[q]; j = (uint32_t)lb[q];
        if (n + DEMI_TILE/2 < count) {          /* neighbours may lie far apart */
            const uint32_t next = (uint32_t)lb[q + DEMI_TILE/2];
            DEMI_FETCH(DEMI_AT(u, next));
            if (turning) DEMI_FETCH(DEMI_AT(s, next));
            if (following) { DEMI_FETCH(DEMI_AT(uh, next)); DEMI_FETCH(DEMI_AT(sh, next)); }
        }
        a = DEMI_AT(x, i); b = DEMI_AT(x, j); c = shift + image[q];
        demi_rows_shifted(&t->gap, q, b, a, c);
        if (!uniform) { t->radius[0][q] = a[3]; t->radius[1][q] = b[3]; }
        demi_rows_minus(&t->rate, q, DEMI_AT(u, i), DEMI_AT(u, j));
        if (turning) demi_rows_plus(&t->around, q, DEMI_AT(s, i), DEMI_AT(s, j));
        if (parting) demi_rows_minus(&t->apart, q, DEMI_AT(s, i), DEMI_AT(s, j));
        if (!following) continue;
        demi_rows_minus(&t->gone, q, DEMI_AT(uh, i), DEMI_AT(uh, j));
        demi_rows_plus(&t->turned, q, DEMI_AT(sh, i), DEMI_AT(sh, j));
        if (parting) demi_rows_minus(&t->parted, q, DEMI_AT(sh, i), DEMI_AT(sh, j));
    }
}
/* What the scene asks for is known before the tile: a copy of the loop for each case, without a
   question inside. */
static void demi_tile_fetch(const demi_run *r, int count, demi_tile *DEMI_RESTRICT t) {
    /* where differences of spins are wanted, radii cost little, even those of alike bodies */
    if (r->parting && r->following) demi_fetch(r, count, t, 0, 1, 1, 1);
    else if (r->parting) demi_fetch(r, count, t, 0, 1, 1, 0);
    else if (r->following) demi_fetch(r, count, t, 1, 1, 0, 1);
    else demi_fetch(r, count, t, r->alike, r->turning, 0, 0);
}

/* Slip over the step just taken, in the tangent plane of now: velocity and spin (times arm) are
   means of the step, so the normal they are taken across is that of its middle. Rigid motion of
   both gives zero. */
DEM_INLINE dem_vec3 demi_slip_step(dem_vec3 normal, dem_vec3 mid, dem_vec3 gone, dem_vec3 around) {
    const dem_vec3 t = demi_sub(gone, demi_scale(mid, demi_dot(gone, mid)));
    const dem_vec3 slip = demi_add(t, demi_cross(around, mid));
    return demi_sub(slip, demi_scale(normal, demi_dot(slip, normal)));
}

/* --- stages: each runs over all pairs of a tile before the next begins. Processors then have
   several pairs under way at once, where one long chain of roots and quotients would keep them
   waiting. `full` is a whole number of groups; pairs to fill up the last one are nobody's. --- */
#define DEMI_ROWS(full) { int g, l; \
    for (g = 0; g < (full); g += DEMI_LANES) { \
        DEMI_VECTOR \
        for (l = 0; l < DEMI_LANES; l++) { const int q = g + l;
#define DEMI_ROWS_END }}}

/* touch: distance, normal, overlap */
DEM_INLINE void demi_touch_one(demi_tile *DEMI_RESTRICT t, const demi_same *s, int q, int uniform) {
    const dem_vec3 gap = demi_rows_at(&t->gap, q);
    const dem_real d = DEMI_SQRT(demi_dot(gap, gap)), over_d = 1/(d + DEMI_TINY);
    dem_real overlap;
    t->length[q] = d;
    t->over_d[q] = over_d;
    demi_row_put(t->normal, q, demi_scale(gap, over_d));
    if (uniform) {
        overlap = 2*s->radius - d;
        t->deep[q] = overlap*s->inv_radius;
    } else {
        const dem_real ra = t->radius[0][q], rb = t->radius[1][q];
        overlap = ra + rb - d;
        t->deep[q] = overlap*(1/(ra < rb ? ra : rb));
        t->lean[q] = (ra - rb)/(ra + rb)*d/2;   /* the contact divides d as the radii do */
    }
    t->touch[q] = overlap > 0 ? DEM_R(1) : DEM_R(0);
    t->overlap[q] = overlap > 0 ? overlap : 0;
}
/* motion: how the two move at the contact, now and over the step just taken */
DEM_INLINE void demi_motion_one(demi_tile *DEMI_RESTRICT t, const demi_same *s, int q, int uniform,
                                int turning, int following) {
    const dem_vec3 n = demi_row(t->normal, q), rate = demi_rows_at(&t->rate, q);
    const dem_real d = t->length[q], closing = demi_dot(rate, n);
    t->closing[q] = closing;
    if (turning) {          /* la wa + lb wb, from sum and difference */
        dem_vec3 arm = demi_scale(demi_rows_at(&t->around, q), d/2);
        if (!uniform) arm = demi_add(arm, demi_scale(demi_rows_at(&t->apart, q), t->lean[q]));
        demi_row_put(t->slip, q, demi_add(demi_sub(rate, demi_scale(n, closing)),
                                          demi_cross(arm, n)));
    }
    if (following) {
        const dem_vec3 gone = demi_rows_at(&t->gone, q), turned = demi_rows_at(&t->turned, q);
        const dem_vec3 turn = demi_scale(demi_sub(gone, demi_scale(n, demi_dot(gone, n))),
                                         -t->over_d[q]);
        const dem_vec3 mid = demi_sub(n, demi_scale(turn, s->dt/2));
        dem_vec3 arm = demi_scale(turned, d/2);
        if (!uniform) arm = demi_add(arm, demi_scale(demi_rows_at(&t->parted, q), t->lean[q]));
        demi_row_put(t->turn, q, turn);
        demi_row_put(t->slip_step, q, demi_slip_step(n, mid, gone, arm));
        t->twist[q] = demi_dot(turned, n)/2;
    }
}
#define DEMI_MOTION_STAGE(NAME, UNIFORM, TURNING, FOLLOWING) \
    DEMI_CLONES static void demi_stage_##NAME(demi_tile *DEMI_RESTRICT t, const demi_run *r, \
                                              int full) { \
        const demi_same s = r->same; \
        DEMI_ROWS(full) demi_touch_one(t, &s, q, UNIFORM); DEMI_ROWS_END \
        DEMI_ROWS(full) demi_motion_one(t, &s, q, UNIFORM, TURNING, FOLLOWING); DEMI_ROWS_END \
    }
DEMI_MOTION_STAGE(alike_bare, 1, 0, 0)
DEMI_MOTION_STAGE(mixed_bare, 0, 0, 0)
DEMI_MOTION_STAGE(alike_turning, 1, 1, 0)
DEMI_MOTION_STAGE(mixed_turning, 0, 1, 0)
DEMI_MOTION_STAGE(alike_following, 1, 1, 1)
DEMI_MOTION_STAGE(mixed_following, 0, 1, 1)

/* Pair q as a law sees it; compilers leave out what the law does not look at. */
DEM_INLINE void demi_tile_contact(demi_tile *DEMI_RESTRICT t, const demi_same *s, int q,
                                  dem_contact *c) {
    c->normal = demi_row(t->normal, q);
    c->overlap = t->overlap[q];
    c->closing_speed = t->closing[q];
    c->slip = demi_row(t->slip, q);
    c->spin = demi_rows_at(&t->apart, q);
    c->slip_step = demi_row(t->slip_step, q);
    c->spin_step = demi_rows_at(&t->parted, q);
    c->normal_rate = demi_row(t->turn, q);
    c->twist = t->twist[q];
    c->dt = s->dt;
    c->kn = t->coef[DEMI_KN][q]; c->cn = t->coef[DEMI_CN][q];
    c->kt = t->coef[DEMI_KT][q]; c->ct = t->coef[DEMI_CT][q];
    c->kun = t->coef[DEMI_K_UN][q]; c->kad = t->coef[DEMI_K_AD][q];
    c->friction = t->coef[DEMI_MU][q]; c->friction_static = t->coef[DEMI_MU_STATIC][q];
    c->rolling_friction = t->coef[DEMI_MU_ROLL][q];
    c->r_eff = t->coef[DEMI_R_EFF][q];
    c->m_eff = t->coef[DEMI_M_EFF][q];
    c->tension = s->tension;
    c->friction_load = s->friction_load;
    c->slider = s->slider;
    c->wall = 0;
}
/* A law's memory of pair q: `count` reals from `at` on. What does not touch forgets. */
#define DEMI_RECALL(e) m[e] = e < count ? t->memory[at + e][q] : 0
#define DEMI_KEEP(e) if (e < count) t->memory[at + e][q] = m[e]*t->touch[q]
DEM_INLINE void demi_recall(demi_tile *DEMI_RESTRICT t, int q, int at, int count, dem_real *m) {
    DEMI_EIGHT(DEMI_RECALL);
}
DEM_INLINE void demi_keep(demi_tile *DEMI_RESTRICT t, int q, int at, int count,
                          const dem_real *m) {
    DEMI_EIGHT(DEMI_KEEP);
}
#undef DEMI_RECALL
#undef DEMI_KEEP
/* What a law says of energy, for the ledger. */
DEM_INLINE void demi_normal_energy(demi_tile *DEMI_RESTRICT t, int q, const dem_contact_force *f) {
    t->part[0][q] = (f->energy.dashpot + f->energy.sag)*t->touch[q];
    t->part[1][q] = f->energy.elastic*t->touch[q];
}
DEM_INLINE void demi_tangent_energy(demi_tile *DEMI_RESTRICT t, int q, const dem_contact_force *f) {
    t->part[2][q] = f->energy.shear_work*t->touch[q];
    t->part[3][q] = f->energy.slide*t->touch[q];
    t->part[4][q] = f->energy.shear_stored*t->touch[q];
}
/* What a law has put into its answer, for the next; `all`: 1: also what only some of them ask for,
   2: and energies. */
DEM_INLINE void demi_normal_put(demi_tile *DEMI_RESTRICT t, int q, const dem_contact_force *f,
                                int all) {
    t->repulsion[q] = f->normal;
    t->load[q] = f->load;
    t->kt[0][q] = f->kt;
    t->ct[q] = f->ct;
    if (!all) return;
    t->kt[1][q] = f->kt_step;
    t->slope[0][q] = f->slope;
    t->slope[1][q] = f->slope_step;
    if (all > 1) demi_normal_energy(t, q, f);
}
/* What the normal law has told, for the laws that come after it. */
DEM_INLINE void demi_normal_get(demi_tile *DEMI_RESTRICT t, int q, dem_contact_force *f) {
    demi_force_clear(f);
    f->load = t->load[q];
    f->kt = t->kt[0][q]; f->kt_step = t->kt[1][q];
    f->slope = t->slope[0][q]; f->slope_step = t->slope[1][q];
    f->ct = t->ct[q];
}
DEM_INLINE void demi_tangent_put(demi_tile *DEMI_RESTRICT t, int q, const dem_contact_force *f,
                                 int all) {
    demi_row_put(t->tangent, q, f->tangent);
    if (all > 1) demi_tangent_energy(t, q, f);
}
DEM_INLINE void demi_rolling_put(demi_tile *DEMI_RESTRICT t, int q, const dem_contact_force *f,
                                 int all) {
    (void)all;
    demi_row_put(t->moment, q, f->moment);
    t->part[5][q] = f->energy.roll*t->touch[q];
}
/* A stage of one law, whose memory begins at AT. Normal and friction laws have one for what is
   common (ALL 0) and one for all choices (2); normal laws one for what is common, with slopes (1),
   too. (A normal law overwrites all that it gets.) */
#define DEMI_LAW_STAGE(NAME, LAW, AT, MEMORY, ALL, PUT) \
    DEMI_CLONES static void NAME(demi_tile *DEMI_RESTRICT t, const demi_run *r, int full) { \
        const demi_same s = r->same; \
        DEMI_ROWS(full) \
            dem_contact c; dem_contact_force f; dem_real m[DEMI_MEMORY]; \
            demi_tile_contact(t, &s, q, &c); \
            if ((ALL) < 2) demi_contact_usual(&c); \
            demi_normal_get(t, q, &f); \
            demi_recall(t, q, AT, MEMORY, m); \
            dem_law_##LAW(&c, m, &f); \
            demi_keep(t, q, AT, MEMORY, m); \
            PUT(t, q, &f, ALL); \
        DEMI_ROWS_END \
    }
#define DEMI_NORMAL_STAGES(KIND, LAW, MEMORY, VECTORS, TRAITS, TEXT) \
    DEMI_LAW_STAGE(demi_stage_##LAW, LAW, s.at_normal, MEMORY, 0, demi_normal_put) \
    DEMI_LAW_STAGE(demi_stage_##LAW##_precise, LAW, s.at_normal, MEMORY, 1, demi_normal_put) \
    DEMI_LAW_STAGE(demi_stage_##LAW##_all, LAW, s.at_normal, MEMORY, 2, demi_normal_put)
#define DEMI_TANGENT_STAGES(KIND, LAW, MEMORY, VECTORS, TRAITS, TEXT) \
    DEMI_LAW_STAGE(demi_stage_##LAW, LAW, 0, MEMORY, 0, demi_tangent_put) \
    DEMI_LAW_STAGE(demi_stage_##LAW##_all, LAW, 0, MEMORY, 2, demi_tangent_put)
#define DEMI_ROLLING_STAGES(KIND, LAW, MEMORY, VECTORS, TRAITS, TEXT) \
    DEMI_LAW_STAGE(demi_stage_##LAW, LAW, s.at_rolling, MEMORY, 2, demi_rolling_put)
DEMI_NORMAL_LAWS(DEMI_NORMAL_STAGES)
DEMI_TANGENT_LAWS(DEMI_TANGENT_STAGES)
DEMI_ROLLING_LAWS(DEMI_ROLLING_STAGES)

/* answer: force and torques. What does not touch answers zero. */
DEM_INLINE void demi_answer_one(demi_tile *DEMI_RESTRICT t, int q, dem_real repulsion,
                                dem_vec3 tangent, dem_vec3 moment, int uniform, int turning,
                                int parting) {
    const dem_real touch = t->touch[q];
    const dem_vec3 n = demi_row(t->normal, q);
    tangent = demi_scale(tangent, touch);
    demi_row_put(t->force, q, demi_sub(tangent, demi_scale(n, repulsion*touch)));
    if (turning) {
        const dem_vec3 across = demi_cross(n, tangent);
        const dem_real half = t->length[q]/2, lean = uniform ? 0 : t->lean[q];
        if (parting) {
            moment = demi_scale(moment, touch);
            demi_row_put(t->torque[0], q, demi_add(demi_scale(across, half + lean), moment));
            demi_row_put(t->torque[1], q, demi_sub(demi_scale(across, half - lean), moment));
        } else demi_row_put(t->torque[0], q, demi_scale(across, half));  /* the same on both */
    }
}
#define DEMI_ANSWER_STAGE(NAME, UNIFORM, TURNING, PARTING, MOMENT) \
    DEMI_CLONES static void demi_stage_##NAME(demi_tile *DEMI_RESTRICT t, const demi_run *r, \
                                              int full) { \
        (void)r; \
        DEMI_ROWS(full) \
            demi_answer_one(t, q, t->repulsion[q], \
                            TURNING ? demi_row(t->tangent, q) : demi_v(0, 0, 0), \
                            MOMENT ? demi_row(t->moment, q) : demi_v(0, 0, 0), \
                            UNIFORM, TURNING, PARTING); \
        DEMI_ROWS_END \
    }
DEMI_ANSWER_STAGE(answer_bare, 1, 0, 0, 0)
DEMI_ANSWER_STAGE(answer_alike, 1, 1, 0, 0)
DEMI_ANSWER_STAGE(answer_mixed, 0, 1, 1, 0)
DEMI_ANSWER_STAGE(answer_alike_rolling, 1, 1, 1, 1)
DEMI_ANSWER_STAGE(answer_mixed_rolling, 0, 1, 1, 1)

/* All laws and the answer at once, for the commonest scenes. Memory: friction's FRICTION reals,
   then rolling's. */
#define DEMI_WHOLE_STAGE(NAME, NORMAL, TANGENT, FRICTION, ROLLING, MEMORY, UNIFORM, TURNING, \
                         ROLLS, LEDGER) \
    DEMI_CLONES static void demi_stage_##NAME(demi_tile *DEMI_RESTRICT t, const demi_run *r, \
                                              int full) { \
        const demi_same s = r->same; \
        DEMI_ROWS(full) \
            dem_contact c; dem_contact_force f; dem_real m[DEMI_MEMORY]; \
            demi_tile_contact(t, &s, q, &c); \
            demi_contact_usual(&c); \
            demi_force_clear(&f); \
            NORMAL(&c, 0, &f); \
            demi_recall(t, q, 0, MEMORY, m); \
            TANGENT(&c, m, &f); \
            ROLLING(&c, m + (FRICTION), &f); \
            demi_keep(t, q, 0, MEMORY, m); \
            demi_answer_one(t, q, f.normal, f.tangent, f.moment, UNIFORM, TURNING, \
                            (TURNING && !(UNIFORM)) || (ROLLS)); \
            if (LEDGER) { demi_normal_energy(t, q, &f); demi_tangent_energy(t, q, &f); } \
            if ((LEDGER) && (ROLLS)) t->part[5][q] = f.energy.roll*t->touch[q]; \
        DEMI_ROWS_END \
    }
#ifndef DEM_NO_SPECIALIZE
#define DEMI_NO_LAW(c, m, f) ((void)0)
DEMI_WHOLE_STAGE(hertz_alone, dem_law_hertz, DEMI_NO_LAW, 0, DEMI_NO_LAW, 0, 1, 0, 0, 0)
#define DEMI_WHOLE_SPRING(NAME, UNIFORM, LEDGER) \
    DEMI_WHOLE_STAGE(NAME, dem_law_hertz, dem_law_spring, 3, DEMI_NO_LAW, 3, UNIFORM, 1, 0, \
                     LEDGER)
#define DEMI_WHOLE_ROLLING(NAME, UNIFORM, LEDGER) \
    DEMI_WHOLE_STAGE(NAME, dem_law_hertz, dem_law_spring, 3, dem_law_roll_epsd, 6, UNIFORM, 1, 1, \
                     LEDGER)
DEMI_WHOLE_SPRING(spring_alike, 1, 0)
DEMI_WHOLE_SPRING(spring_mixed, 0, 0)
DEMI_WHOLE_SPRING(spring_alike_ledger, 1, 1)
DEMI_WHOLE_SPRING(spring_mixed_ledger, 0, 1)
DEMI_WHOLE_ROLLING(rolling_alike, 1, 0)
DEMI_WHOLE_ROLLING(rolling_mixed, 0, 0)
DEMI_WHOLE_ROLLING(rolling_alike_ledger, 1, 1)
DEMI_WHOLE_ROLLING(rolling_mixed_ledger, 0, 1)
#endif

/* The user's law: only what touches, one by one; inlined into the loop where DEM_LAW names it. */
DEM_INLINE void demi_own_one(demi_tile *DEMI_RESTRICT t, const demi_run *r, int q,
                             dem_law_fn law) {
    dem_contact c;
    dem_contact_force f;
    dem_real m[DEMI_MEMORY];
    demi_tile_contact(t, &r->same, q, &c);
    c.material_a = r->w->bodies.material[r->span->a[q]];
    c.material_b = r->w->bodies.material[r->span->b[q]];
    c.user = r->w->desc.law_user;
    demi_force_clear(&f);
    demi_recall(t, q, 0, r->keep, m);
    law(&c, m, &f);
    demi_keep(t, q, 0, r->keep, m);
    demi_answer_one(t, q, f.normal, f.tangent, f.moment, r->alike, 1, 1);
    if (!r->ledger) return;                     /* what the law says of it */
    demi_normal_energy(t, q, &f);
    demi_tangent_energy(t, q, &f);
    t->part[5][q] = f.energy.roll*t->touch[q];
}
/* A law of the user's own is asked pair by pair, and only about those that touch. */
static void demi_stage_own(demi_tile *DEMI_RESTRICT t, const demi_run *r, int full) {
    int q, e;
    (void)full;
    for (q = 0; q < r->span->count; q++) {
        if (t->touch[q] > 0) { demi_own_one(t, r, q, r->w->desc.law); continue; }
        demi_row_put(t->force, q, demi_v(0, 0, 0));
        demi_row_put(t->torque[0], q, demi_v(0, 0, 0));
        demi_row_put(t->torque[1], q, demi_v(0, 0, 0));
        for (e = 0; e < r->keep; e++) t->memory[e][q] = 0;
        for (e = 0; e < 6; e++) t->part[e][q] = 0;
    }
}
#ifdef DEM_LAW
DEMI_CLONES static void demi_stage_own_inlined(demi_tile *DEMI_RESTRICT t, const demi_run *r,
                                               int full) {
    DEMI_ROWS(full) demi_own_one(t, r, q, DEM_LAW); DEMI_ROWS_END
}
#endif

/* --- which stages a scene runs --- */
typedef struct demi_stage_row { demi_stage common, all, precise; } demi_stage_row;
#define DEMI_STAGE_ROW_NORMAL(KIND, LAW, MEMORY, VECTORS, TRAITS, TEXT) \
    {demi_stage_##LAW, demi_stage_##LAW##_all, demi_stage_##LAW##_precise},
#define DEMI_STAGE_ROW_TANGENT(KIND, LAW, MEMORY, VECTORS, TRAITS, TEXT) \
    {demi_stage_##LAW, demi_stage_##LAW##_all, 0},
#define DEMI_STAGE_ROW_ROLLING(KIND, LAW, MEMORY, VECTORS, TRAITS, TEXT) \
    {demi_stage_##LAW, demi_stage_##LAW, 0},
/* in the order of the rows in >>laws */
static const demi_stage_row demi_normal_stages[] = {DEMI_NORMAL_LAWS(DEMI_STAGE_ROW_NORMAL)
    {0, 0, 0}};
static const demi_stage_row demi_tangent_stages[] = {{0, 0, 0}, {0, 0, 0},
    DEMI_TANGENT_LAWS(DEMI_STAGE_ROW_TANGENT) {0, 0, 0}};
static const demi_stage_row demi_rolling_stages[] = {{0, 0, 0}, {0, 0, 0},
    DEMI_ROLLING_LAWS(DEMI_STAGE_ROW_ROLLING) {0, 0, 0}};

/* The stage that does all for the laws in force, or null. */
static demi_stage demi_whole_stage(const dem_world *w, int alike) {
    (void)alike;
#ifdef DEM_LAW
    if (w->desc.law == DEM_LAW) return demi_stage_own_inlined;
#endif
    if (w->desc.law) return demi_stage_own;
#ifndef DEM_NO_SPECIALIZE
    if (w->composed || !demi_laws_usual(w) || w->normal != DEM_NORMAL_HERTZ) return 0;
    if (w->effects.tangent == DEM_TANGENT_NONE && w->effects.rolling == DEM_ROLLING_NONE &&
        !w->desc.ledger)
        return demi_stage_hertz_alone;
    if (w->effects.tangent == DEM_TANGENT_SPRING && w->effects.rolling == DEM_ROLLING_NONE)
        return w->desc.ledger
            ? alike ? demi_stage_spring_alike_ledger : demi_stage_spring_mixed_ledger
            : alike ? demi_stage_spring_alike : demi_stage_spring_mixed;
    if (w->effects.tangent == DEM_TANGENT_SPRING && w->effects.rolling == DEM_ROLLING_EPSD)
        return w->desc.ledger
            ? alike ? demi_stage_rolling_alike_ledger : demi_stage_rolling_mixed_ledger
            : alike ? demi_stage_rolling_alike : demi_stage_rolling_mixed;
#endif
    return 0;
}
/* What the laws in force ask of a run: what is fetched, and which stages. dt 0: looking only.
   Bits of pairs of alike bodies are the same either way. */
static demi_run demi_run_of(const dem_world *w, dem_real dt, int alike) {
    const demi_laws *laws = &w->laws;
    const demi_stage whole = demi_whole_stage(w, alike);
    const int own = w->desc.law != 0;
    const int turns = laws->tangent->law != 0, rolls = laws->rolling->law != 0;
    const int all = w->desc.ledger || !demi_laws_usual(w);
    demi_run r;
    int k = 0;
    memset(&r, 0, sizeof r);
    r.w = w;
    r.alike = alike;
    r.ledger = w->desc.ledger;
    r.keep = w->memory_stride;
    r.turning = own || turns || rolls;
    r.parting = own || rolls || (r.turning && !r.alike);
    r.following = own || laws->tangent->vectors || laws->rolling->vectors;
    r.same.at_rolling = laws->at_rolling;
    r.same.at_normal = laws->at_normal;
    r.same.tension = (int)w->desc.tension;
    r.same.friction_load = (int)w->desc.friction_load;
    r.same.slider = (int)w->desc.slider;
    r.same.dt = dt;
    r.same.radius = w->effects.species[0].radius;
    r.same.inv_radius = 1/r.same.radius;
    r.stage[k++] = r.following ? r.alike ? demi_stage_alike_following : demi_stage_mixed_following
        : r.turning ? r.alike ? demi_stage_alike_turning : demi_stage_mixed_turning
        : r.alike ? demi_stage_alike_bare : demi_stage_mixed_bare;
    if (whole) { r.stage[k] = whole; return r; }
    r.stage[k++] = all ? demi_normal_stages[w->normal].all
        : demi_laws_precise(w) ? demi_normal_stages[w->normal].precise
        : demi_normal_stages[w->normal].common;
    if (turns) r.stage[k++] = all ? demi_tangent_stages[w->effects.tangent].all
                                  : demi_tangent_stages[w->effects.tangent].common;
    if (rolls) r.stage[k++] = demi_rolling_stages[w->effects.rolling].common;
    r.stage[k] = !r.turning ? demi_stage_answer_bare
        : rolls ? r.alike ? demi_stage_answer_alike_rolling : demi_stage_answer_mixed_rolling
        : r.alike ? demi_stage_answer_alike : demi_stage_answer_mixed;
    return r;
}
/* Rows that no stage of the run fills: coefficients that are the same for all pairs, friction of
   none. */
static void demi_tile_begin(const dem_world *w, int d, demi_tile *t) {
    const demi_domain *domain = &w->domains[d];
    const int first = demi_near_first(domain);
    dem_real coef[DEMI_PAIR_COLUMNS];
    int e, q;
    t->row = -1;
    for (q = 0; q < DEMI_TILE && !demi_laws_precise(w); q++)
        t->slope[0][q] = t->slope[1][q] = t->kt[1][q] = (dem_real)NAN;
    if (first < domain->near_end) {
        const demi_span one = demi_span_of(w, d, first, 1);
        demi_span_coefs(w, &one, 0, coef);
        if (!demi_laws_sized(w)) coef[DEMI_R_EFF] = coef[DEMI_M_EFF] = (dem_real)NAN;
        for (e = 0; e < DEMI_PAIR_COLUMNS; e++)
            for (q = 0; q < DEMI_TILE; q++) t->coef[e][q] = coef[e];
    }
    memset(t->part, 0, sizeof t->part);
    memset(t->tangent, 0, sizeof t->tangent);
}
/* Coefficients of a tile's pairs, but those that never vary (demi_species_vary, laid once by
   demi_tile_begin). Answers the run they are for: of the two, that for pairs that differ, or that
   for pairs that are alike, which needs no radii, no difference of spins and one torque for both.
   What a tile of one row fills in is left for the tiles after it, and not copied again; it is
   filled in to the tile's end, because those may be longer. */
static demi_run *demi_tile_coefs(const dem_world *w, const demi_span *span, int full,
                                 demi_tile *DEMI_RESTRICT t, demi_run *run) {
    const int32_t *DEMI_RESTRICT row = span->row;
    const int n = w->effects.species_count;
    int e, q, differ = 0, same;
    if (w->effects.uniform) return run + 1;
    for (q = 0; q < full && row; q++) differ |= row[q]^row[0];
    same = row && !differ;
    for (e = 0; e < DEMI_PAIR_COLUMNS && !(same && t->row == row[0]); e++) {
        const dem_real *DEMI_RESTRICT table = w->species_coef + e;
        if (!(w->species_vary >> e & 1)) continue;
        if (!row) demi_row_copy(t->coef[e], span->coef + (size_t)e*span->stride, full);
        else if (differ) for (q = 0; q < full; q++) t->coef[e][q] = table[DEMI_PAIR_COLUMNS*row[q]];
        else for (q = 0; q < DEMI_TILE; q++)    /* all of it: the next tile may be longer */
            t->coef[e][q] = table[DEMI_PAIR_COLUMNS*row[0]];
    }
    t->row = same ? row[0] : -1;
    if (!same || row[0]%(n + 1)) return run;    /* species k with k: row k*n + k */
    run[1].same.radius = w->effects.species[row[0]/(n + 1)].radius;
    run[1].same.inv_radius = 1/run[1].same.radius;
    return run + 1;
}

/* The whole tile, by one of two runs, which is answered; energies are summed in order. */
static demi_run *demi_tile_respond(const dem_world *w, const demi_span *span, demi_run *run,
                                   demi_tile *DEMI_RESTRICT t, double *energy) {
    const int full = (span->count + DEMI_LANES - 1)/DEMI_LANES*DEMI_LANES;
    demi_run *r = demi_tile_coefs(w, span, full, t, run);
    int q, k;
    r->span = span;
    for (q = 0; q < r->keep; q++)
        demi_row_copy(t->memory[q], span->memory + (size_t)q*span->stride, full);
    demi_tile_fetch(r, full, t);
    for (k = 0; k < DEMI_STAGES && r->stage[k]; k++) r->stage[k](t, r, full);
    for (q = 0; q < r->keep; q++)
        demi_row_copy(span->memory + (size_t)q*span->stride, t->memory[q], full);
    if (r->ledger)
        for (q = 0; q < span->count; q++) {
            energy[DEMI_E_DASHPOT] += (double)t->part[0][q];
            energy[DEMI_E_ELASTIC] += (double)t->part[1][q];
            energy[DEMI_E_SHEAR_WORK] += (double)t->part[2][q];
            energy[DEMI_E_SLIDE] += (double)t->part[3][q];
            energy[DEMI_E_SHEAR_STORED] += (double)t->part[4][q];
            energy[DEMI_E_ROLL] += (double)t->part[5][q];
        }
    return r;
}

/* What a tile adds up to besides forces. */
typedef struct demi_tally { dem_real deepest, contacts; } demi_tally;
/* Pairs that fill up the last group are left out here: `count` is that of the real ones. */
static void demi_tile_tally(const demi_tile *DEMI_RESTRICT t, int count, demi_tally *sum) {
    int q;
    for (q = 0; q < count; q++) {
        sum->deepest = t->deep[q] > sum->deepest ? t->deep[q] : sum->deepest;
        sum->contacts += t->touch[q];
    }
}
DEM_INLINE void demi_sum_add(dem_real *sum, dem_real x, dem_real y, dem_real z) {
    x += sum[0]; y += sum[1]; z += sum[2];
    sum[0] = x; sum[1] = y; sum[2] = z;
}
/* Adds a tile's pushes to both bodies. */
DEM_INLINE void demi_scatter(demi_tile *DEMI_RESTRICT t, const demi_span *span,
                             dem_real *DEMI_RESTRICT force, dem_real *DEMI_RESTRICT torque,
                             int turning, int second) {
    const int32_t *DEMI_RESTRICT la = span->a, *DEMI_RESTRICT lb = span->b;
    const int count = span->count;
    int n;
    for (n = 0; n < count; n++) {
        const size_t q = (size_t)n;
        const int32_t i = la[q], j = lb[q];
        const dem_real fx = t->force[0][q], fy = t->force[1][q], fz = t->force[2][q];
        demi_sum_add(DEMI_AT(force, i), fx, fy, fz);
        demi_sum_add(DEMI_AT(force, j), -fx, -fy, -fz);
        if (!turning) continue;
        demi_sum_add(DEMI_AT(torque, i), t->torque[0][0][q], t->torque[0][1][q],
                     t->torque[0][2][q]);
        demi_sum_add(DEMI_AT(torque, j), t->torque[second][0][q], t->torque[second][1][q],
                     t->torque[second][2][q]);
    }
}
/* Forces of a tile go to both bodies, pair after pair in the order of the list: sums of several
   reals depend on their order, which therefore never changes. */
static void demi_tile_scatter(demi_tile *DEMI_RESTRICT t, const demi_span *span,
                              const demi_run *r, dem_real *DEMI_RESTRICT force,
                              dem_real *DEMI_RESTRICT torque) {
    if (r->parting) demi_scatter(t, span, force, torque, 1, 1);
    else if (r->turning) demi_scatter(t, span, force, torque, 1, 0);
    else demi_scatter(t, span, force, torque, 0, 0);
}
/* The same for pairs that lead out: the far ends' pushes stay in slots, six reals each. */
static void demi_tile_send(demi_tile *DEMI_RESTRICT t, const demi_span *span,
                               const demi_run *r, dem_real *DEMI_RESTRICT force,
                               dem_real *DEMI_RESTRICT torque, dem_real *DEMI_RESTRICT out) {
    const int second = r->parting ? 1 : 0;
    int q;
    for (q = 0; q < span->count; q++, out += 6) {
        dem_real *fa = DEMI_AT(force, span->a[q]), *ma = DEMI_AT(torque, span->a[q]);
        const dem_vec3 f = demi_row(t->force, q);
        fa[0] += f.x; fa[1] += f.y; fa[2] += f.z;
        out[0] = -f.x; out[1] = -f.y; out[2] = -f.z;
        if (r->turning) {
            const dem_vec3 m = demi_row(t->torque[0], q);
            ma[0] += m.x; ma[1] += m.y; ma[2] += m.z;
            demi_put(out + 3, demi_row(t->torque[second], q));
        }
    }
}

/* All pairs of one domain: those inside it, then those that lead out. */
static void demi_pairs(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    const dem_real dt = w->stage.forces_valid ? w->clock.dt : 0;           /* 0: looking only */
    demi_run run[2];
    DEMI_ALIGNED demi_tile tile;
    demi_tally tally = {0, 0};
    int l, p;
    run[0] = demi_run_of(w, dt, 0);
    run[1] = demi_run_of(w, dt, 1);
    demi_tile_begin(w, d, &tile);
    for (l = 0; l < 2; l++) {
        const int begin = l ? domain->near_cross : 0;
        const int end = l ? domain->near_end : domain->near_own;
        for (p = begin; p < end; p += DEMI_TILE) {
            const int count = DEMI_MIN((int)DEMI_TILE, end - p);
            const demi_span span = demi_span_of(w, d, p, count);
            const demi_run *r = demi_tile_respond(w, &span, run, &tile, domain->energy);
            demi_tile_tally(&tile, count, &tally);
            if (!l) demi_tile_scatter(&tile, &span, r, w->bodies.force, w->bodies.torque);
            else demi_tile_send(&tile, &span, r, w->bodies.force, w->bodies.torque,
                                w->cross_force + 6*((size_t)d*(size_t)w->cross.stride +
                                                   (size_t)(p - begin)));
        }
    }
    domain->contacts = (int)tally.contacts;
    domain->overlap = DEMI_MAX(domain->overlap, (double)tally.deepest);
}

/* The far ends of pairs that lead into domain d from domains before it. */
static void demi_cross_gather(dem_world *w, int d) {
    const int turning = demi_spins(w);
    const int stride = w->cross.stride;
    int k, e, p, shaped, from = 0;
    for (k = w->cross_incoming_start[d]; k < w->cross_incoming_start[d + 1]; k++) {
        const int entry = w->cross_incoming[k], j = 4*w->cross.b[entry];
        const dem_real *force;
        while (entry >= (from + 1)*stride) from++;
        p = w->cross.place[entry] - 1;
        if (p < 0) continue;
        shaped = p >= w->domains[from].near_shaped;
        p -= shaped ? w->domains[from].near_shaped_cross - w->domains[from].near_end : 0;
        force = w->cross_force + 6*(size_t)(from*stride + p - w->domains[from].near_cross);
        for (e = 0; e < 3; e++) {
            w->bodies.force[j + e] += force[e];
            if (turning || shaped) w->bodies.torque[j + e] += force[3 + e];
        }
    }
}

/* Sets the loop over pairs for the laws in force; answers what reports call it. */
static const char *demi_kernel_choose(dem_world *w) {
    w->kernel = demi_pairs;
#ifdef DEM_LAW
    if (w->desc.law == DEM_LAW) return "your law, inlined";
#endif
    if (w->desc.law) return "your law, called";
    return demi_whole_stage(w, w->effects.uniform) ? "all laws at once" : "law by law";
}

#if defined(__GNUC__) && !defined(__clang__) && !defined(__TINYC__)
#pragma GCC pop_options
#endif

/* ---------------------------------------------------------------------------------------------
   >>on-walls
   Where parts of bodies touch walls: geometry only; first spheres, clusters being many of them;
   then ellipsoids, which share what is done on surfaces of facets; then who touches what.
   What becomes of the places that are found stands in >>kept.
   --------------------------------------------------------------------------------------------- */

/* m: as far as any grain and any wall have come towards each other since the list was made. */
DEM_INLINE dem_real demi_walls_gone(const dem_world *w) {
    return (dem_real)(w->margin.gone + w->margin.walls_gone);
}
/* Room in which the places of one body and one wall are found. candidates: how many there are. */
DEM_INLINE demi_places demi_places_begin(const dem_world *w, int d, int candidates) {
    const demi_domain *domain = &w->domains[d];
    demi_places p;
    memset(&p, 0, sizeof p);
    p.at = w->touching + domain->touching_first;
    if (candidates > 10) {
        uint32_t size = 64;
        while (size < 2*7*(uint32_t)candidates) size *= 2;
        p.table = w->touching_table + 4*domain->touching_first;
        p.mask = size - 1;
        memset(p.table, 0, size*sizeof *p.table);
    }
    return p;
}
/* Candidates from k on that see the wall from the same image of their body: the end of them. */
DEM_INLINE int demi_image_end(const dem_world *w, int base, int k, int last) {
    const dem_real *s = w->wall_shift + 3*(size_t)(base + k);
    int end = k + 1;
    if (!w->repeating) return last;
    while (end < last && !memcmp(s, w->wall_shift + 3*(size_t)(base + end), 3*sizeof *s)) end++;
    return end;
}
/* Can candidate k, an element of a wall, be nearer than `within` to a place? No where its gap has
   not closed, or its plane is farther off. */
DEM_INLINE int demi_facet_near(const dem_world *w, const demi_wall *wall, int k, dem_real gone,
                               dem_vec3 x, dem_real within) {
    const dem_real *plane = DEMI_AT(wall->planes, w->wall_element[k]);
    const dem_real off = plane[0]*x.x + plane[1]*x.y + plane[2]*x.z - plane[3];
    return !(w->wall_gap[k] > gone) &&
           !(DEMI_ABS(off) > within*DEM_R(1.001) + wall->plane_slack);
}
/* Where an ellipsoid (part; null: a sphere of radius r) at `at` touches a surface of facets, from
   the candidates first .. last - 1 of its body: normals, points and shares, and what is left of its
   measure, r less the distance or 1 - W0, as overlaps. In the world. */
static int demi_facets_touch(const dem_world *w, int d, int first, int last, dem_real gone,
                             dem_vec3 at, dem_real r, const demi_part *part, demi_touching **out) {
    const int base = d*w->wall_stride;
    const demi_wall *wall = &w->walls[w->wall_id[base + first]];
    const dem_real *R = wall->pose.rotation;
    const dem_real within = part ? DEM_R(1) : r;
    demi_places p = demi_places_begin(w, d, last - first);
    const int numbers = wall->number_count;
    int k, q, from, end, one, reached;
    for (k = first; k < last; k = end, p.offset += numbers) {   /* image by image */
        const dem_vec3 shift = demi_at(w->wall_shift + 3*(size_t)(base + k));
        const dem_vec3 x = demi_unrotate(R, demi_sub(demi_add(at, shift), wall->pose.position));
        from = p.count;
        end = demi_image_end(w, base, k, last);
        for (q = k, one = end, reached = 0; q < end && !part; q++) {
            if (!demi_facet_near(w, wall, base + q, gone, x, within)) continue;
            if (!reached++) one = q;
        }
        if (reached == 1 && wall->lone) {
            demi_facet_alone(wall, w->wall_element[base + one], x, within, &p);
            if (p.count > from) p.at[from].shift = shift;
            continue;
        }
        for (q = one; q < end; q++)             /* spheres have a copy of the code for them */
            if (demi_facet_near(w, wall, base + q, gone, x, within))
                demi_facet_places(wall, w->wall_element[base + q], x, 0, within, &p);
        for (q = k; q < end && part; q++)
            if (!(w->wall_gap[base + q] > gone))
                demi_facet_places(wall, w->wall_element[base + q], x, part, within, &p);
        for (q = from; q < p.count && !(p.at[q].share < DEM_R(-1e-3)); q++) continue;
        if (q < p.count)                        /* something takes away: more than it should? */
            demi_places_rings(wall, w->wall_element + base + k, end - k, x, part, within,
                              demi_normal_is(w, DEMI_HERTZIAN) ? DEM_R(2.5) : DEM_R(2),
                              w->touching_links +
                              w->domains[d].touching_first, &p);
        for (q = from; q < p.count; q++) p.at[q].shift = shift;
    }
    if (p.count > 1 || (p.count && p.at->share < 1))
        demi_places_merge(&p, within*(DEMI_SINGLE ? DEM_R(2e-5) : DEM_R(1e-9)));
    for (k = 0; k < p.count; k++) {
        demi_touching *t = p.at + k;
        dem_vec3 to = t->point, n = t->point;
        t->element %= numbers;
        if (part) {
            const dem_vec3 a = part->axes;
            to = dem_quat_rotate(part->q, demi_v(n.x*a.x, n.y*a.y, n.z*a.z));
            n = dem_quat_rotate(part->q, demi_v(n.x/a.x, n.y/a.y, n.z/a.z));
        }
        n = t->overlap > 0 ? demi_scale(n, 1/demi_length(n)) : demi_v(0, 0, -1);
        t->overlap = within - t->overlap;
        t->normal = demi_rotate(R, n);
        t->point = demi_add(at, demi_rotate(R, to));
    }
    *out = p.at;
    return p.count;
}
/* --- where one part of a body, a sphere or an ellipsoid, touches one wall, from the candidates
       first .. last - 1 of its body, those no farther than `gone`: normals, points, overlaps (of an
       ellipsoid 1 - W0) and shares, in the world. at: its centre. --- */
typedef int (*demi_touch_fn)(const dem_world *w, int d, int first, int last, dem_real gone,
                             dem_vec3 at, const demi_part *part, demi_touching **places);
static int demi_facets_spheres(const dem_world *w, int d, int first, int last, dem_real gone,
                               dem_vec3 at, const demi_part *part, demi_touching **places) {
    return demi_facets_touch(w, d, first, last, gone, at, part->radius, 0, places);
}
/* A sphere and a wall each of whose elements it may touch; how: 0: as it is near to them, 1: as
   segments that push with a fraction, 2: as a sieve, one candidate and as many contacts as there
   are. */
DEM_INLINE int demi_spheres_touch(const dem_world *w, int d, int first, int last, dem_real gone,
                                  dem_vec3 at, dem_real r, demi_touching **places, int how,
                                  demi_near_fn near) {
    const int base = d*w->wall_stride;
    const demi_wall *wall = &w->walls[w->wall_id[base + first]];
    const dem_real *R = wall->pose.rotation;
    demi_touching *out;
    int k, q, end, count = 0;
    *places = out = w->touching + w->domains[d].touching_first;
    for (k = first; k < last; k = end) {
        const dem_vec3 shift = demi_at(w->wall_shift + 3*(size_t)(base + k));
        const dem_vec3 x = demi_unrotate(R, demi_sub(demi_add(at, shift), wall->pose.position));
        const int from = count;
        end = demi_image_end(w, base, k, last);
        if (how == 2) count += demi_sieve_touch(&wall->sieve, x, r, out + count);
        else for (; k < end; k++) {
            demi_touching *c = &out[count];
            if (w->wall_gap[base + k] > gone) continue;
            c->element = w->wall_element[base + k];
            c->share = wall->share;
            if (how == 1) {
                c->share = demi_segment_share(wall, c->element, x, r, &c->normal, &c->point,
                                              &c->overlap);
                if (!(c->share > 0)) continue;
            } else {
                c->overlap = near(wall, c->element, x, r, &c->normal, &c->point);
                if (!(c->overlap > 0)) continue;
            }
            count++;
        }
        for (q = from; q < count; q++) {
            out[q].normal = demi_rotate(R, out[q].normal);
            out[q].point = demi_sub(demi_add(wall->pose.position, demi_rotate(R, out[q].point)),
                                    shift);
            out[q].shift = shift;
        }
    }
    return count;
}
static int demi_plane_spheres(const dem_world *w, int d, int first, int last, dem_real gone,
                              dem_vec3 at, const demi_part *part, demi_touching **places) {
    return demi_spheres_touch(w, d, first, last, gone, at, part->radius, places, 0,
                              demi_plane_near);
}
static int demi_cylinder_spheres(const dem_world *w, int d, int first, int last, dem_real gone,
                                 dem_vec3 at, const demi_part *part, demi_touching **places) {
    return demi_spheres_touch(w, d, first, last, gone, at, part->radius, places, 0,
                              demi_cylinder_near);
}
/* Any other wall of elements. */
static int demi_elements_touch(const dem_world *w, int d, int first, int last, dem_real gone,
                               dem_vec3 at, const demi_part *part, demi_touching **places) {
    const int kind = w->walls[w->wall_id[d*w->wall_stride + first]].kind;
    return demi_spheres_touch(w, d, first, last, gone, at, part->radius, places, 0,
                              demi_nears[kind]);
}
static int demi_segments_touch(const dem_world *w, int d, int first, int last, dem_real gone,
                               dem_vec3 at, const demi_part *part, demi_touching **places) {
    return demi_spheres_touch(w, d, first, last, gone, at, part->radius, places, 1, 0);
}
static int demi_sieve_spheres(const dem_world *w, int d, int first, int last, dem_real gone,
                              dem_vec3 at, const demi_part *part, demi_touching **places) {
    return demi_spheres_touch(w, d, first, last, gone, at, part->radius, places, 2, 0);
}

/* --- an ellipsoid and a wall element, in the wall's frame; Q: of the ellipsoid there --- */

/* A largest value, near an angle, of n.x + h (out = 1: the farthest point from the origin) or of
   n.x - h (out = -1: the nearest, as a distance), h = sqrt(n.Q n), n = (cos, sin), for the ellipse
   of Q's first two rows about x: by Newton's method, uphill where the curve bends up. n: the
   direction. */
static double demi_ellipse_far(const double *Q, double x, double y, int out, double angle,
                                 double *n) {
    int k;
    for (k = 0;; k++) {
        const double c = cos(angle), s = sin(angle);
        const double qn0 = Q[0]*c + Q[3]*s, qn1 = Q[3]*c + Q[1]*s;
        const double h = sqrt(c*qn0 + s*qn1), cross = -s*qn0 + c*qn1;
        const double best = c*x + s*y + out*h, size = fabs(x) + fabs(y) + h;
        const double slope = -s*x + c*y + out*cross/h;
        const double bend = -(c*x + s*y) +
            out*((Q[0] + Q[1])/h - 2*h - cross*cross/(h*h*h));
        const int still = fabs(slope) < 1e-14*size;
        double step;
        n[0] = c;
        n[1] = s;
        if (k == 60 || (still && bend < 1e-9*size)) return best;
        /* where it bends up: away from the lowest point, never more than half a radian */
        step = still ? 0.01 : bend < 0 ? -slope/bend : slope > 0 ? 0.3 : -0.3;
        angle += step > 0.5 ? 0.5 : step < -0.5 ? -0.5 : step;
    }
}
/* Height of an ellipsoid in direction n, and the arm to its surface point there: Q n/h. */
static dem_real demi_ellipsoid_arm(const demi_part *p, dem_vec3 n, dem_vec3 *arm) {
    const dem_vec3 e = dem_quat_unrotate(p->q, n), a = p->axes;
    const dem_vec3 s = demi_v(a.x*e.x, a.y*e.y, a.z*e.z);
    const dem_real h = demi_length(s);
    *arm = demi_scale(dem_quat_rotate(p->q, demi_v(a.x*s.x, a.y*s.y, a.z*s.z)), 1/h);
    return h;
}
/* What is left of an ellipsoid about x inside a cylinder's radius R as it shrinks (or, from
   outside, beyond it): 1 - W0, at the scale W0 it only just touches; n: where, across the axis.
   Newton's method on W, whose far end goes with its height there; from W = 1, where n has been
   found. */
static double demi_ellipse_shrink(const double *Q, double x, double y, int out, double R,
                                  double far, double *n) {
    double W = 1;
    int k;
    for (k = 0; k < 20; k++) {
        const double h = sqrt(n[0]*n[0]*Q[0] + 2*n[0]*n[1]*Q[3] + n[1]*n[1]*Q[1]);
        const double step = out*(R - far)/h;
        double S[6];
        int e;
        W += step;
        if (!(W > 1e-3)) return 1 - 1e-3;
        for (e = 0; e < 6; e++) S[e] = W*W*Q[e];
        far = demi_ellipse_far(S, x, y, out, atan2(n[1], n[0]), n);
        if (fabs(step) < 1e-15) break;
    }
    return 1 - W;
}
/* --- one ellipsoid, turned into the wall's frame, against one element, centre x: fills in normal
       and point, answers 1 - W0, 0 or less when apart --- */
typedef dem_real (*demi_ellipsoid_fn)(const demi_wall *wall, int element, const demi_part *p,
                                      dem_vec3 x, dem_vec3 *normal, dem_vec3 *point);
/* Its lowest point; W0 is the height of its centre over its own. */
static dem_real demi_ellipsoid_on_plane(const demi_wall *wall, int element, const demi_part *p,
                                        dem_vec3 x, dem_vec3 *normal, dem_vec3 *point) {
    dem_vec3 arm;
    dem_real h;
    (void)wall; (void)element;
    *normal = demi_v(0, 0, -1);
    h = demi_ellipsoid_arm(p, *normal, &arm);
    *point = demi_v(x.x + arm.x*x.z/h, x.y + arm.y*x.z/h, 0);
    return 1 - x.z/h;
}
/* Inside, either end of a long body may touch: element 0 and 1. */
static dem_real demi_ellipsoid_on_cylinder(const demi_wall *wall, int element, const demi_part *p,
                                           dem_vec3 x, dem_vec3 *normal, dem_vec3 *point) {
    double Q[6], n[3], far, left;
    dem_vec3 arm;
    demi_ellipsoid_matrix(p->q, p->axes, Q);
    far = demi_ellipse_far(Q, (double)x.x, (double)x.y, wall->inside ? 1 : -1, wall->inside
                             ? atan2(2*Q[3], Q[0] - Q[1])/2 + (element ? DEMI_PI : 0)
                             : atan2((double)x.y, (double)x.x), n);
    left = far - (double)wall->radius;
    if (!(wall->inside ? left > 0 : left < 0)) return 0;
    left = demi_ellipse_shrink(Q, (double)x.x, (double)x.y, wall->inside ? 1 : -1,
                               (double)wall->radius, far, n);
    *normal = demi_v((dem_real)n[0], (dem_real)n[1], 0);
    if (!wall->inside) *normal = demi_scale(*normal, -1);
    demi_ellipsoid_arm(p, *normal, &arm);
    *point = demi_v((dem_real)n[0]*wall->radius, (dem_real)n[1]*wall->radius,
                    x.z + arm.z*(dem_real)(1 - left));
    return (dem_real)left;
}
static dem_real demi_ellipsoid_on_grain(const demi_wall *wall, int element, const demi_part *p,
                                        dem_vec3 x, dem_vec3 *normal, dem_vec3 *point) {
    const dem_vec3 gap = demi_sub(demi_at(wall->vertices + 3*element), x);
    double Q[6], B[6], r[3], n[3], ha, hb;
    demi_meet m;
    demi_ellipsoid_matrix(p->q, p->axes, Q);
    demi_ball_matrix(wall->radius, B);
    r[0] = (double)gap.x; r[1] = (double)gap.y; r[2] = (double)gap.z;
    if (!(demi_dot3(r, r) > 0)) r[2] = 1e-9*(double)demi_part_thin(p);
    m.l = demi_meet_start(Q, B, r);
    demi_meet_solve(Q, B, r, 1, DEMI_MEET_NEAR, &m);
    if (!(m.f < 1)) return 0;
    demi_meet_heights(&m, n, &ha, &hb);
    *normal = demi_v((dem_real)n[0], (dem_real)n[1], (dem_real)n[2]);
    *point = demi_add(x, demi_v((dem_real)((1 - m.l)*m.a[0]), (dem_real)((1 - m.l)*m.a[1]),
                                (dem_real)((1 - m.l)*m.a[2])));
    return (dem_real)(1 - sqrt(m.f));
}
/* An ellipsoid as the wall's frame sees it. */
static demi_part demi_part_local(const demi_wall *wall, const demi_part *p) {
    const dem_real *R = wall->pose.rotation;
    demi_part local = *p;
    double turn[3][3];
    int i, e;
    for (i = 0; i < 3; i++) for (e = 0; e < 3; e++) turn[i][e] = (double)R[3*e + i];
    local.q = demi_quat_unit(dem_quat_times(demi_quat_of(turn), p->q));
    return local;
}
static int demi_facets_ellipsoid(const dem_world *w, int d, int first, int last, dem_real gone,
                                 dem_vec3 at, const demi_part *part, demi_touching **places) {
    const demi_part local = demi_part_local(&w->walls[w->wall_id[d*w->wall_stride + first]], part);
    return demi_facets_touch(w, d, first, last, gone, at, 0, &local, places);
}
/* An ellipsoid and a wall, element by element. */
static int demi_ellipsoid_touch(const dem_world *w, int d, int first, int last, dem_real gone,
                                dem_vec3 at, const demi_part *part, demi_touching **places,
                                demi_ellipsoid_fn on) {
    const int base = d*w->wall_stride;
    const demi_wall *wall = &w->walls[w->wall_id[base + first]];
    const dem_real *R = wall->pose.rotation;
    const demi_part local = demi_part_local(wall, part);
    const int two = wall->inside;
    demi_touching *out;
    dem_vec3 x, shift;
    int i, count = 0;
    *places = out = w->touching + w->domains[d].touching_first;
    for (i = first; i < last + two; i++) {
        demi_touching *c = &out[count];
        if (w->wall_gap[base + DEMI_MIN(i, last - 1)] > gone) continue;
        shift = demi_at(w->wall_shift + 3*(size_t)(base + DEMI_MIN(i, last - 1)));
        x = demi_unrotate(R, demi_sub(demi_add(at, shift), wall->pose.position));
        c->element = i < last ? w->wall_element[base + i] : 1;
        c->overlap = on(wall, c->element, &local, x, &c->normal, &c->point);
        if (!(c->overlap > 0)) continue;
        c->normal = demi_rotate(R, c->normal);
        if (two && count && demi_dot(c->normal, out->normal) > DEM_R(0.99)) continue;
        c->point = demi_sub(demi_add(wall->pose.position, demi_rotate(R, c->point)), shift);
        c->shift = shift;
        c->share = wall->share;
        count++;
    }
    return count;
}
static int demi_plane_ellipsoid(const dem_world *w, int d, int first, int last, dem_real gone,
                                dem_vec3 at, const demi_part *part, demi_touching **places) {
    return demi_ellipsoid_touch(w, d, first, last, gone, at, part, places, demi_ellipsoid_on_plane);
}
static int demi_cylinder_ellipsoid(const dem_world *w, int d, int first, int last, dem_real gone,
                                   dem_vec3 at, const demi_part *part, demi_touching **places) {
    return demi_ellipsoid_touch(w, d, first, last, gone, at, part, places,
                                demi_ellipsoid_on_cylinder);
}
static int demi_grain_ellipsoid(const dem_world *w, int d, int first, int last, dem_real gone,
                                dem_vec3 at, const demi_part *part, demi_touching **places) {
    return demi_ellipsoid_touch(w, d, first, last, gone, at, part, places, demi_ellipsoid_on_grain);
}

/* Who touches what: walls by kind, and parts by theirs. */
#define DEMI_WALL_TOUCH(KIND, C, M, T, N, NEAR, TOUCH, BEND) DEMI_LIST TOUCH,
static const demi_touch_fn demi_touches[][DEMI_SHAPE_KINDS] = {{0}, DEMI_WALLS(DEMI_WALL_TOUCH)};
static int demi_touch_known(int kind, int part) { return demi_touches[kind][part] != 0; }

/* ---------------------------------------------------------------------------------------------
   >>kept
   Contacts that are kept by themselves: all but those of sphere and sphere (>>respond). Two bodies
   may touch in several places and each may push past the centre; a wall is touched in as many
   places as it has surfaces near: so these contacts are kept one by one. touch finds them (geometry
   only: parts against parts, parts against wall elements) and which of the step before each
   continues; respond takes memory over from that one, asks the law and pushes. Within a domain they
   stand in the order of their body a. Touch may run out of room; it then begins anew with more,
   nothing lost.
   --------------------------------------------------------------------------------------------- */

/* One contact as touch finds it. */
static demi_kept *demi_kept_new(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    demi_kept *c;
    if (domain->kept_next >= w->kept_first[d + 1] - w->kept_first[d]) {
        domain->overflow |= 16;
        return 0;
    }
    c = w->kept_next + w->kept_first[d] + domain->kept_next++;
    memset(c, 0, offsetof(demi_kept, coef));
    c->b = -1;
    c->share = c->slope = c->inset = 1;
    return c;
}

/* --- touch: two bodies --- */

/* --- two parts, if they touch: geometry into c. lambda: where to begin, 0: unknown --- */
typedef int (*demi_meet_fn)(const dem_world *w, const demi_part *p, const demi_part *q,
                            dem_vec3 gap, double lambda, demi_kept *c);
/* Two spheres share the distance as their radii do. */
static int demi_balls_touch(const dem_world *w, const demi_part *p, const demi_part *q,
                            dem_vec3 gap, double lambda, demi_kept *c) {
    const dem_real d = demi_length(gap), sum = p->radius + q->radius;
    (void)w; (void)lambda;
    if (!(d < sum)) return 0;
    c->normal = d > 0 ? demi_scale(gap, 1/d) : demi_v(0, 0, 1);
    c->overlap = sum - d;
    c->deep = c->overlap/DEMI_MIN(p->radius, q->radius);
    c->r_eff = p->radius*q->radius/sum;
    c->arm_a = demi_add(p->centre, demi_scale(c->normal, d*p->radius/sum));
    c->arm_b = demi_sub(c->arm_a, demi_sub(demi_add(p->centre, gap), q->centre));
    c->bend = -1/DEMI_MAX(d, sum/10);
    return 1;
}
/* Ellipsoids, or one and a sphere, as Perram and Wertheim's point does. */
static int demi_ellipsoids_touch(const dem_world *w, const demi_part *p, const demi_part *q,
                                 dem_vec3 gap, double lambda, demi_kept *c) {
    const dem_real d = demi_length(gap);
    double A[6], B[6], r[3], n[3], ha, hb, w0, ra, rb;
    demi_meet m;
    r[0] = (double)gap.x; r[1] = (double)gap.y; r[2] = (double)gap.z;
    if (!(d > 0)) r[2] = 1e-9*(double)demi_part_thin(p);
    demi_part_matrix(p, A);
    demi_part_matrix(q, B);
    m.l = lambda > 0 ? lambda : demi_meet_start(A, B, r);
    demi_meet_solve(A, B, r, 1, DEMI_MEET_NEAR, &m);
    if (!(m.f < 1)) return 0;
    w0 = sqrt(m.f);
    demi_meet_heights(&m, n, &ha, &hb);
    c->lambda = m.l;
    c->normal = demi_v((dem_real)n[0], (dem_real)n[1], (dem_real)n[2]);
    c->deep = (dem_real)((1 - w0)*(ha + hb))/DEMI_MIN(demi_part_thin(p), demi_part_thin(q));
    c->overlap = (dem_real)((1 - w0)*(ha + hb));
    if (w->desc.ellipsoid_overlap == DEM_OVERLAP_CONSERVATIVE) {
        const double l = demi_part_equal(p) + demi_part_equal(q);
        c->overlap = (dem_real)((1 - w0)*l);
        c->slope = (dem_real)(l/(ha + hb));
    } else if (w->desc.ellipsoid_overlap == DEM_OVERLAP_CHORD)
        c->overlap = (dem_real)demi_meet_chord(&m, A);
    ra = demi_part_round(w, p, ha);
    rb = demi_part_round(w, q, hb);
    c->r_eff = (dem_real)(ra*rb/(ra + rb));
    c->arm_a = demi_add(p->centre, demi_v((dem_real)((1 - m.l)*m.a[0]),
        (dem_real)((1 - m.l)*m.a[1]), (dem_real)((1 - m.l)*m.a[2])));
    /* from b's centre to the same point, to the bit: angular momentum */
    c->arm_b = demi_sub(c->arm_a, demi_sub(demi_add(p->centre, gap), q->centre));
    return 1;
}
/* Who meets whom: kinds of parts, the later one first. */
#define DEMI_SHAPE_MEET(KIND, NAME, WORD, GAP, TOUCH) DEMI_LIST TOUCH,
static const demi_meet_fn demi_meets[][DEMI_SHAPE_KINDS] = {DEMI_SHAPES(DEMI_SHAPE_MEET)};
DEM_INLINE demi_meet_fn demi_meet_of(int kind, int other) {
    return demi_meets[DEMI_MAX(kind, other)][DEMI_MIN(kind, other)];
}
static int demi_meet_known(int kind, int other) { return demi_meet_of(kind, other) != 0; }

/* Number in its domain of the old contact with the same partner and parts, or with the same wall,
   part and element, among those that body a had; -1: none. */
DEM_INLINE int demi_kept_same(const dem_world *w, int d, const demi_kept *old, int olds, int b,
                              int part_a, int part_b, int wall, int element) {
    int i;
    for (i = 0; i < olds; i++)
        if (old[i].element == element && old[i].wall == wall && old[i].part_a == part_a &&
            old[i].b == b && old[i].part_b == part_b)
            return (int)(old - demi_kept_of(w, d)) + i;
    return -1;
}
/* How well an old contact fits a new one: by their normals; where those are nearly the same (within
   some 3 degrees), rather one that nothing continues yet; then the same wall, and the same sign of
   what they count. */
DEM_INLINE dem_real demi_match(dem_vec3 old, dem_vec3 now, int taken, int wall, int sign) {
    const dem_real hair = DEMI_SINGLE ? DEM_R(1e-5) : DEM_R(1e-10);
    return demi_dot(old, now) + (taken ? 0 : DEM_R(1e-3)) + (wall ? hair : 0) + (sign ? 2*hair : 0);
}
/* The same for a contact with a wall where that finds none: the one of the same part and of nearest
   normal, within about 18 degrees, that nothing else continues: the grain slid on to the neighbour.
   A place of a surface that begins at depth has split off another one, and takes a copy of its
   memory: as often as two come, one that takes away comes with them (>>facets). Walls that do not
   move against each other are one here. fresh: all that are new with this wall. */
static int demi_kept_slid(const dem_world *w, int d, const demi_kept *old, int olds,
                          const demi_kept *fresh, int freshs, const demi_kept *c) {
    const int first = (int)(old - demi_kept_of(w, d));
    dem_real nearest = 0;
    int i, j, best = -1;
    for (i = 0; i < olds; i++) {
        dem_real along;
        int taken = 0;
        if (!(demi_dot(old[i].normal, c->normal) > DEM_R(0.95)) || old[i].b >= 0 ||
            old[i].part_a != c->part_a ||
            w->walls[old[i].wall].group != w->walls[c->wall].group) continue;
        for (j = 0; j < freshs && !taken; j++)
            taken = fresh[j].wall == old[i].wall && fresh[j].element == old[i].element;
        along = demi_match(old[i].normal, c->normal, taken, old[i].wall == c->wall,
                           (old[i].weight < 0) == (c->share < 0));
        if (!(along > nearest)) continue;
        if (taken && (!demi_faceted(&w->walls[c->wall]) || !(2*c->overlap > old[i].overlap)))
            continue;
        nearest = along;
        best = first + i;
    }
    return best;
}
/* 1/mass that a force along n through arm feels at a body: 1/m + (arm x n).I^-1 (arm x n). */
static double demi_inverse_mass_at(const dem_world *w, int body, dem_vec3 arm, dem_vec3 n) {
    const double inv = (double)w->bodies.inv_mass[body];
    const dem_real *I = w->bodies.orienting ? w->bodies.moment + 4*body : 0;
    dem_vec3 t;
    if (!(inv > 0) || !demi_shape_of(w, body)) return inv;
    t = dem_quat_unrotate(demi_quat_at(w->bodies.orient + 4*body), demi_cross(arm, n));
    return inv + (double)(t.x*t.x/I[0] + t.y*t.y/I[1] + t.z*t.z/I[2]);
}

/* How far two contacts of one pair push the same way, t: 1 within 25 degrees, 0 beyond 45. *rate:
   how t changes with the cosine between their normals. Those of one part are not shared: they are
   counted already, by what they weigh. */
DEM_INLINE dem_real demi_kept_along(const demi_kept *a, const demi_kept *b, dem_real *rate) {
    const dem_real zero = DEM_R(0.7071067811865476), one = DEM_R(0.9063077870366499);
    const dem_real t = (demi_dot(a->normal, b->normal) - zero)/(one - zero);
    *rate = t > 0 && t < 1 ? 6*t*(1 - t)/(one - zero) : 0;
    return !(t > 0) ? 0 : t < 1 ? t*t*(3 - 2*t) : 1;
}
DEM_INLINE dem_real demi_kept_alike(const demi_kept *a, const demi_kept *b, dem_real *rate) {
    *rate = 0;
    return a->part_a == b->part_a && a->part_b == b->part_b ? 0 : demi_kept_along(a, b, rate);
}
/* The force aside on contact c's ball that has c's normal turn towards, or away from, another's:
   -(dE/dt)(dt/dcos) d(n.other)/dx. push: the first two. */
DEM_INLINE void demi_kept_aside(demi_kept *c, dem_vec3 other, dem_real push) {
    const dem_real along = demi_dot(other, c->axis);
    dem_vec3 turn = demi_sub(other, demi_scale(c->normal, demi_dot(other, c->normal)));
    turn = demi_sub(turn, demi_scale(c->axis, along));
    turn = demi_add(demi_scale(turn, c->bend), demi_scale(c->axis, along*c->along));
    c->aside = demi_add(c->aside, demi_scale(turn, push));
}
/* Exponent of R* in the stiffness of a body's contacts: 1/2 for Hertz; linear: 2/5, or 0 where the
   stiffness is given. */
static dem_real demi_kept_power(const dem_world *w, const demi_kept *c) {
    const int a = w->bodies.material[c->a] - 1;
    const int b = c->b < 0 ? w->walls[c->wall].material : w->bodies.material[c->b] - 1;
    if (demi_normal_is(w, DEMI_HERTZIAN)) return DEM_R(0.5);
    return w->pairs[a*DEMI_MATERIALS + b].given.stiffness > 0 ? DEM_R(0) : DEM_R(0.4);
}
/* U'(d_i) over U'(d_k), of contacts that overlap: q, exponent of R*, as above. */
static dem_real demi_kept_steep(const demi_kept *i, const demi_kept *k, int hertz, dem_real q) {
    const dem_real more = i->overlap/k->overlap, R = i->r_eff/k->r_eff;
    if (hertz) return more*DEMI_SQRT(more*R);
    return q > 0 && (R < 1 || R > 1) ? more*(dem_real)pow((double)R, (double)q) : more;
}
/* What the shared energy (below) asks of contacts whose shares are known: lift, aside, grip. */
static void demi_kept_lift(const dem_world *w, demi_kept *c, int n) {
    const int hertz = demi_normal_is(w, DEMI_HERTZIAN);
    const dem_real p = hertz ? DEM_R(2.5) : DEM_R(2), q = demi_kept_power(w, c);
    dem_real rate;
    int i, k;
    for (k = 0; k < n; k++) {
        const dem_real d = c[k].overlap, own = c[k].share*d/p;     /* E_k over U'(d_k) */
        if (!(d > 0)) continue;
        c[k].lift = c[k].share*(1 + 2/p*c[k].rate*c[k].added*d*d/c[k].area);
        for (i = 0; i < n; i++) {
            const dem_real t = i == k ? 0 : demi_kept_alike(&c[i], &c[k], &rate);
            const dem_real e = c[i].overlap;
            dem_real far;                       /* E_i over U'(d_k) and A_i */
            if (!(t > 0) || !(e > 0)) continue;
            far = demi_kept_steep(&c[i], &c[k], hertz, q)*c[i].share*e/p*c[i].rate/c[i].area;
            c[k].lift -= far*2*t*c[k].weight*d;
            if (rate > 0)
                demi_kept_aside(&c[k], c[i].normal, rate*(far*c[k].weight*d*d +
                                  own*c[k].rate/c[k].area*c[i].weight*e*e));
        }
    }
    for (k = 0; k < n; k++) {
        dem_real lift = 0, share = 0, own = 0;
        if (!(c[k].overlap > 0)) continue;
        for (i = 0; i < n; i++) {
            const dem_real t = i == k ? 1 : demi_kept_along(&c[i], &c[k], &rate);
            dem_real press;                     /* U'(d_i) over U'(d_k) */
            if (!(t > 0) || !(c[i].overlap > 0)) continue;
            press = t*demi_kept_steep(&c[i], &c[k], hertz, q);
            lift += press*c[i].lift;
            share += press*c[i].share;
            if (i == k) own = press;
        }
        if (share > DEM_R(0.1)*own && lift > 0) c[k].grip = c[k].share*lift/share;
        else c[k].grip = c[k].share;
    }
}
/* Room that contact i leaves to itself: 1 + x, x what the others add, over d_i^2; where others take
   away (>>facets) smoothly no less than a quarter. *rate: how it changes with x. */
static dem_real demi_kept_room_of(dem_real x, dem_real *rate) {
    const dem_real below = DEM_R(0.0625)/(DEM_R(-0.25) - x);    /* x < -1/2 */
    *rate = x < DEM_R(-0.5) ? 16*below*below : DEM_R(1);
    return x < DEM_R(-0.5) ? DEM_R(0.25) + below : 1 + x;
}
/* Contacts of one pair (or of a body and a wall), c[0] .. c[n - 1], that are one in all. With
   overlaps d, weights w (>>facets; else 1), what each stores U(d), and t: do i and j push the same
   way,
       A_i = d_i^2 + sum of t_ij w_j d_j^2, j not i;   s_i = w_i d_i^2/A_i;   E = sum of s_i U(d_i)
   a mean in which the deep ones count more: alike ones store what one would, whatever their number,
   and one that begins or ends counts nothing: stiffness, damping and restitution do not grow with
   the number of spheres that happen to touch [BER23]. The elastic force is the gradient of E, which
   conserves: of contact k, along its normal, dE/dd_k = lift_k U'(d_k); and across it, as far as its
   normal turns with its place, that of the t. With U ~ sqrt(R) d^p (Hertz) or d^p
       E_i = s_i U'(d_i) d_i/p,          dE_k/dd_k = s_k U'(d_k) (1 + 2/p (A_k - d_k^2)/A_k)
       dE_i/dd_k = -E_i 2 t_ik w_k d_k/A_i,    dE_i/dt_ik = -E_i w_k d_k^2/A_i
   (Left out: how an ellipsoid's normal turns at a cluster's ball. A ball that is
   nearly at what it goes round, within a tenth of its radius, turns no faster than there.)
   It may be a little below 0 where others are far deeper: no mean that does not depend on their
   number can do without. Damping goes by s, and feels the mass at their common middle; friction by
   s times (sum of lift U' over sum of s U'), so that mu is the ratio of both sums. Checked by "a
   cluster that lands on one, two and three spheres" and tests/test_facets.c. */
static void demi_kept_share(const dem_world *w, demi_kept *c, int n) {
    const int one = w->desc.cluster_contacts == DEM_SHARING_ONE;
    int i, j;
    for (i = 0; i < n; i++) {
        const dem_real d2 = c[i].overlap*c[i].overlap;
        dem_vec3 arm_a = demi_scale(c[i].arm_a, d2), arm_b = demi_scale(c[i].arm_b, d2);
        dem_real A = d2, rate;
        double give;
        c[i].weight = c[i].lift = c[i].grip = c[i].share;
        c[i].m_eff = w->bodies.mass[c[i].a];
        if (!(c[i].overlap > 0)) continue;      /* pushes nobody */
        for (j = 0; j < n && one; j++) {
            const dem_real t = j == i ? 0 : demi_kept_alike(&c[i], &c[j], &rate);
            const dem_real add = t*c[j].overlap*c[j].overlap*(j < i ? c[j].weight : c[j].share);
            if (!(t > 0)) continue;
            A += add;
            arm_a = demi_add(arm_a, demi_scale(c[j].arm_a, add));
            arm_b = demi_add(arm_b, demi_scale(c[j].arm_b, add));
        }
        c[i].added = A/d2 - 1;
        c[i].area = d2*demi_kept_room_of(c[i].added, &c[i].rate);
        c[i].share = c[i].weight*d2/c[i].area;
        if (!(A > d2/2)) {                      /* others take away: its own place will do */
            A = d2;
            arm_a = demi_scale(c[i].arm_a, d2);
            arm_b = demi_scale(c[i].arm_b, d2);
        }
        give = demi_inverse_mass_at(w, c[i].a, demi_scale(arm_a, 1/A), c[i].normal);
        if (c[i].b >= 0)
            give += demi_inverse_mass_at(w, c[i].b, demi_scale(arm_b, 1/A), c[i].normal);
        c[i].m_eff = (dem_real)(1/give);
    }
    if (one && n > 1) demi_kept_lift(w, c, n);
}

/* All contacts of one near pair. old: those body a had in the step before. */
static DEMI_APART void demi_kept_pair(dem_world *w, int d, int at, int send,
                                      const demi_kept *old, int olds) {
    const int a = w->near.a[at], b = w->near.b[at];
    const dem_real *shift = w->image_shift + w->near.image[at];
    const dem_vec3 r = demi_add(demi_sub(demi_at(w->bodies.pos + 4*b),
                                         demi_at(w->bodies.pos + 4*a)),
                                demi_at(shift));
    const dem_real rb = w->bodies.pos[4*b + 3];
    const int na = demi_parts_count(w, a), nb = demi_parts_count(w, b);
    const int first = w->domains[d].kept_next;
    const demi_kept *now = demi_kept_of(w, d);
    demi_kept *from = w->kept_next + w->kept_first[d] + first;
    int i, j;
    if (!(demi_length(r) < w->bodies.pos[4*a + 3] + rb)) return;
    for (i = 0; i < na; i++) {
        const demi_part p = demi_part_now(w, a, i);
        const dem_vec3 to = demi_sub(r, p.centre);
        const dem_real all = p.radius + rb;
        if (na > 1 && !(demi_dot(to, to) < all*all)) continue;
        for (j = 0; j < nb; j++) {
            const demi_part q = demi_part_now(w, b, j);
            const dem_vec3 gap = demi_add(to, q.centre);
            const dem_real sum = p.radius + q.radius;
            demi_kept *c;
            if (!(demi_dot(gap, gap) < sum*sum)) continue;
            c = demi_kept_new(w, d);
            if (!c) return;
            c->a = a; c->b = b; c->part_a = i; c->part_b = j;
            c->wall = c->element = -1;
            c->send = send;
            c->from = demi_kept_same(w, d, old, olds, b, i, j, -1, -1);
            if (!demi_meet_of(p.kind, q.kind)(w, &p, &q, gap,
                                              c->from < 0 ? 0 : now[c->from].lambda, c))
                w->domains[d].kept_next--;
        }
    }
    demi_kept_share(w, from, w->domains[d].kept_next - first);
}

/* --- overlap, arm and radius of a part's contact with a wall at a place that was found --- */
typedef void (*demi_on_wall_fn)(const dem_world *w, const demi_wall *wall, const demi_part *p,
                                const demi_touching *place, demi_kept *c);
DEM_INLINE void demi_ball_on_wall(const dem_world *w, const demi_wall *wall, const demi_part *p,
                                  const demi_touching *place, demi_kept *c) {
    (void)w; (void)wall;
    c->overlap = place->overlap;
    c->deep = c->overlap/p->radius;
    c->r_eff = p->radius;
    c->arm_a = demi_add(p->centre, demi_scale(c->normal, p->radius));
}
/* An ellipsoid's, whose place has 1 - W0 for an overlap: as with other ellipsoids, l (1 - W0), with
   the sphere of a wall's grain in l, or along the normal. The arm is to the point that lies
   deepest, as a sphere's is; what is l (1 - W0)'s gradient passes through the point of the wall, at
   W0 of it. */
static void demi_ellipsoid_on_wall(const dem_world *w, const demi_wall *wall, const demi_part *p,
                                   const demi_touching *place, demi_kept *c) {
    const dem_real h = demi_ellipsoid_arm(p, c->normal, &c->arm_a), left = place->overlap;
    const dem_real edge = demi_wall_is(wall, DEMI_BALLS) ? wall->radius : DEM_R(0);
    c->overlap = left*(h + edge);
    c->deep = c->overlap/demi_part_thin(p);
    c->r_eff = (dem_real)demi_part_round(w, p, (double)h);
    if (w->desc.ellipsoid_overlap == DEM_OVERLAP_CONSERVATIVE) {
        const dem_real l = (dem_real)demi_part_equal(p) + edge;
        c->overlap = left*l;
        c->slope = l/(h + edge);
        c->inset = 1 - left;
    }
}
#define DEMI_SHAPE_ON_WALL(KIND, NAME, WORD, GAP, TOUCH) demi_##NAME##_on_wall,
static const demi_on_wall_fn demi_on_walls[] = {DEMI_SHAPES(DEMI_SHAPE_ON_WALL)};
/* --- how the normal of a ball's contact with a wall turns as the ball moves. dist: m, from the
       ball's centre to the surface. Answers that to what the normal turns about (0: it does not),
       and the axis along which nothing turns, if there is one. among: the elements where the
       contact, with this number, was found. normal: the contact's, in the wall's frame as all else.
       *along: 1/m, where it turns along the axis after all. --- */
typedef dem_real (*demi_bend_fn)(const demi_wall *wall, const int32_t *among, int count, int number,
                                 dem_real dist, dem_vec3 normal, dem_vec3 *axis, dem_real *along);
static dem_real demi_cylinder_bend(const demi_wall *wall, const int32_t *among, int count,
                                   int number, dem_real dist, dem_vec3 normal, dem_vec3 *axis,
                                   dem_real *along) {
    (void)among; (void)count; (void)number; (void)normal; (void)along;
    axis->z = 1;
    return wall->inside ? dist - wall->radius : dist + wall->radius;
}
static dem_real demi_grain_bend(const demi_wall *wall, const int32_t *among, int count,
                                int number, dem_real dist, dem_vec3 normal, dem_vec3 *axis,
                                dem_real *along) {
    (void)among; (void)count; (void)number; (void)normal; (void)axis; (void)along;
    return dist + wall->radius;
}
/* Lines do not turn the normal, corners do, about the direction that a profile is drawn out in. */
static dem_real demi_profile_bend(const demi_wall *wall, const int32_t *among, int count,
                                  int number, dem_real dist, dem_vec3 normal, dem_vec3 *axis,
                                  dem_real *along) {
    (void)among; (void)count; (void)normal; (void)along;
    axis->z = 1;
    return number < wall->element_count ? 0 : dist;
}
/* Faces do not turn the normal; an edge does, about itself; a corner, every way. */
static dem_real demi_mesh_bend(const demi_wall *wall, const int32_t *among, int count,
                               int number, dem_real dist, dem_vec3 normal, dem_vec3 *axis,
                               dem_real *along) {
    const int edges = wall->element_count, corners = edges + wall->edge_count;
    int k, q, found = 0;
    (void)normal; (void)along;
    if (number < edges) return 0;
    for (k = 0; k < count && !found && (number < corners ||
         number >= corners + wall->vertex_count); k++) {
        const int e = among[k];
        dem_vec3 y[3];
        demi_wall_corners(wall, e, y);
        for (q = 0; q < 3 && !found; q++)
            if ((found = edges + wall->edges[3*e + q] == number) != 0)
                *axis = demi_unit(demi_sub(y[(q + 1)%3], y[q]));
        for (q = wall->cut_start ? wall->cut_start[e] : 0;
             wall->cut_start && q < wall->cut_start[e + 1] && !found; q++)
            if ((found = wall->cuts[q].number == number) != 0)
                *axis = demi_unit(demi_sub(wall->cuts[q].b, wall->cuts[q].a));
    }
    return dist;
}
/* Rows turn it about themselves, crossings as points do, round rims about the hole, too: with n_h
   the normal's part in the plate, rho the centre's distance from the hole's axis, by n_h/rho. */
static dem_real demi_sieve_bend(const demi_wall *wall, const int32_t *among, int count, int number,
                                dem_real dist, dem_vec3 normal, dem_vec3 *axis, dem_real *along) {
    const dem_sieve_desc *s = &wall->sieve;
    const int wires = s->kind == DEM_SIEVE_WIRES || s->kind == DEM_SIEVE_BARS;
    const int ring = number == DEMI_SIEVE_RIM, across = number & 1;
    const dem_real flat = DEMI_SQRT(normal.x*normal.x + normal.y*normal.y);
    (void)among; (void)count;
    if (number == DEMI_SIEVE_FACE) return 0;
    if (ring || s->kind == DEM_SIEVE_ROUND) {
        const dem_real R = ring ? s->radius : s->aperture/2;
        const dem_real rho = ring ? R + flat*dist : across ? flat*dist - R : R - flat*dist;
        if (!(flat > 0)) return 0;
        *axis = demi_v(-normal.y/flat, normal.x/flat, 0);
        *along = (ring || across ? -flat : flat)/DEMI_MAX(rho, R/10);
    } else if (number != DEMI_SIEVE_RIM + 1 && !(number & DEMI_SIEVE_CROSS)) {
        if (number & DEMI_SIEVE_ABOVE) return 0;
        *axis = number & DEMI_SIEVE_SET ? demi_v(1, 0, 0) : demi_v(0, 1, 0);
    }
    return wires && !(number & DEMI_SIEVE_CROSS) ? dist + s->bar/2 : dist;
}
#define DEMI_WALL_BEND(KIND, C, M, T, N, NEAR, TOUCH, BEND) BEND,
static const demi_bend_fn demi_bends[] = {0, DEMI_WALLS(DEMI_WALL_BEND)};
/* By the table of kinds. */
static void demi_wall_bend(const demi_wall *wall, const int32_t *among, int count, dem_real dist,
                           demi_kept *c) {
    dem_vec3 axis = demi_v(0, 0, 0);
    const dem_vec3 normal = demi_unrotate(wall->pose.rotation, c->normal);
    if (!demi_bends[wall->kind]) return;
    dist = demi_bends[wall->kind](wall, among, count, c->element, dist, normal, &axis, &c->along);
    if (!(dist < 0 || dist > 0)) return;
    c->bend = -1/dist;
    c->axis = demi_rotate(wall->pose.rotation, axis);
}
/* R* of a part of radius r with a wall. On a round wire the two radii of the contact differ, r and
   r q/(r + q): their geometric mean gives a force 1.5 % below that of Hertz's ellipse for a wire as
   thick as the grain, 7 % for one of a fifth. */
static double demi_wall_r_eff(const demi_wall *wall, double r) {
    const double q = (double)wall->sieve.bar/2;
    if (demi_wall_is(wall, DEMI_BALLS)) return r*(double)wall->radius/(r + (double)wall->radius);
    if (wall->sieve.kind == DEM_SIEVE_WIRES || wall->sieve.kind == DEM_SIEVE_BARS)
        return r*sqrt(q/(r + q));
    return r;
}
/* A sheet, which pushes to both sides, pushes a ball on once its centre is through. Then contact c
   has turned round within a step, and nothing is left of the one before: its overlap is what is
   seen from there. old: those the body had; fresh: all it has with this wall now. */
static void demi_kept_through(const demi_kept *old, int olds, const demi_kept *fresh, int count,
                              demi_kept *c) {
    int e, i;
    for (e = 0; e < olds && c->deep < 1; e++) {
        if (old[e].b >= 0 || old[e].wall != c->wall || old[e].part_a != c->part_a ||
            old[e].deep + c->deep < 1 || demi_dot(old[e].normal, c->normal) > DEM_R(-0.5))
            continue;
        for (i = 0; i < count && !(demi_dot(fresh[i].normal, old[e].normal) > 0); i++);
        if (i == count) c->deep = 2 - c->deep;
    }
}
/* Contacts of part k with one wall, from candidates first .. last - 1 of its body: all of them,
   then what each continues. shaped: 0 for a sphere, which has a copy of the code: its places weigh
   by themselves, as they are found. */
DEM_INLINE void demi_kept_on_wall(dem_world *w, int d, int first, int last, int shaped, int k,
                                  const demi_part *p, const demi_kept *old, int olds) {
    const int base = d*w->wall_stride, body = w->wall_body[base + first];
    const int id = w->wall_id[base + first];
    const demi_wall *wall = &w->walls[id];
    demi_touching *found = 0;
    const int count = demi_touches[wall->kind][p->kind](w, d, first, last, demi_walls_gone(w),
        demi_add(demi_at(w->bodies.pos + 4*body), p->centre), p, &found);
    demi_kept *fresh = 0, *c;
    int i, e;
    for (i = 0; i < count; i++) {
        c = demi_kept_new(w, d);
        if (!c) return;
        if (!i) fresh = c;
        c->a = body;
        c->part_a = k;
        c->wall = id;
        c->element = found[i].element;
        c->normal = found[i].normal;
        c->share = c->weight = c->lift = c->grip = found[i].share;
        c->shift = found[i].shift;
        if (!shaped || p->kind == DEMI_BALL) {  /* the commonest, without a call */
            demi_ball_on_wall(w, wall, p, &found[i], c);
            if (shaped && w->desc.cluster_contacts == DEM_SHARING_ONE && c->overlap > 0)
                demi_wall_bend(wall, w->wall_element + base + first, last - first,
                               DEMI_MAX(p->radius - c->overlap, p->radius/10), c);
        } else demi_on_walls[p->kind](w, wall, p, &found[i], c);
        c->r_eff = (dem_real)demi_wall_r_eff(wall, (double)c->r_eff);
    }
    for (i = 0, c = fresh; i < count; i++, c++) {
        c->from = demi_kept_same(w, d, old, olds, -1, k, 0, id, c->element);
        if (c->from < 0 && olds) c->from = demi_kept_slid(w, d, old, olds, fresh, count, c);
        if (c->deep > DEM_R(0.1) && olds) demi_kept_through(old, olds, fresh, count, c);
        if (wall->sieve.kind != DEM_SIEVE_REDUCED) continue;
        for (e = 0; e < olds; e++)              /* under way: to the end */
            if (old[e].b < 0 && old[e].wall == id && old[e].part_a == k && !(old[e].overlap > 0))
                c->weight = c->lift = c->grip = c->share = 0;
        if (!(c->share > 0)) c->overlap = c->deep = 0;
    }
}
/* Of one body with one wall. */
static DEMI_APART void demi_kept_wall(dem_world *w, int d, int first, int last,
                                      const demi_kept *old, int olds) {
    const int from = w->domains[d].kept_next, body = w->wall_body[d*w->wall_stride + first];
    const int parts = demi_parts_count(w, body);
    int k;
    if (!demi_shape_of(w, body)) {
        const demi_part sphere = demi_part_now(w, body, 0);
        demi_kept_on_wall(w, d, first, last, 0, 0, &sphere, old, olds);
        return;
    }
    for (k = 0; k < parts; k++) {
        const demi_part p = demi_part_now(w, body, k);
        demi_kept_on_wall(w, d, first, last, 1, k, &p, old, olds);
    }
    demi_kept_share(w, w->kept_next + w->kept_first[d] + from, w->domains[d].kept_next - from);
}

/* All of one domain, in the order of body a: its pairs inside, its pairs that lead out, its walls.
   */
static void demi_domain_kept_touch(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    const demi_kept *old = demi_kept_of(w, d), *end = old + domain->kept, *old_end;
    const int32_t *near_a = w->near.a + d*w->near.stride;
    const int32_t *body = w->wall_body + d*w->wall_stride, *wall = w->wall_id + d*w->wall_stride;
    const dem_real *gap = w->wall_gap + d*w->wall_stride, gone = demi_walls_gone(w);
    const int base = d*w->near.stride, walls = domain->walls;
    const int own_end = domain->near_shaped_cross, cross_end = domain->near_shaped_end;
    const int send = 1 + d*w->cross.stride + domain->near_end - domain->near_cross - own_end;
    int p = domain->near_shaped, q = own_end, k = 0, a, last;
    domain->kept_next = 0;
    domain->overflow &= ~16;
    for (; !(domain->overflow & 16); old = old_end) {
        while (k < walls && gap[k] > gone) k++; /* not near yet */
        a = k < walls ? body[k] : INT_MAX;
        if (p < own_end) a = DEMI_MIN(a, near_a[p]);
        if (q < cross_end) a = DEMI_MIN(a, near_a[q]);
        if (a == INT_MAX) return;
        while (old < end && old->a < a) old++;
        for (old_end = old; old_end < end && old_end->a == a;) old_end++;
        if (old_end + 1 < end) DEMI_FETCH(old_end + 1);     /* too far apart for hardware */
        if (k + DEMI_LANES < walls) DEMI_FETCH(w->bodies.pos + 4*body[k + DEMI_LANES]);
        for (; p < own_end && near_a[p] == a; p++)
            demi_kept_pair(w, d, base + p, 0, old, (int)(old_end - old));
        for (; q < cross_end && near_a[q] == a; q++)
            demi_kept_pair(w, d, base + q, send + q, old, (int)(old_end - old));
        for (; k < walls && body[k] == a; k = last) {
            last = k + 1;
            if (gap[k] > gone) continue;
            while (last < walls && body[last] == a && wall[last] == wall[k]) last++;
            demi_kept_wall(w, d, k, last, old, (int)(old_end - old));
        }
    }
}
/* More room for the domains that ran out of it. 0 when memory ran out; nothing changed then. */
static int demi_kept_widen(dem_world *w) {
    int first[DEMI_DOMAINS + 1], d;
    for (d = 0, first[0] = 0; d < DEMI_DOMAINS; d++) {
        const int had = w->kept_first[d + 1] - w->kept_first[d];
        const int more = d < w->domain_count && w->domains[d].overflow & 16 ? had/2 + 64 : 0;
        first[d + 1] = first[d] + had + more;
    }
    if (!DEMI_GROW(w, w->kept_next, (size_t)first[DEMI_DOMAINS]) ||
        !DEMI_GROW(w, w->kept_now, (size_t)first[DEMI_DOMAINS])) return 0;
    for (d = w->domain_count - 1; d > 0; d--)
        memmove(w->kept_now + first[d], demi_kept_of(w, d),
                (size_t)w->domains[d].kept*sizeof(demi_kept));
    memcpy(w->kept_first, first, sizeof w->kept_first);
    return 1;
}
/* All of them. 0 when memory ran out. */
static int demi_touch(dem_world *w) {
    int d, again;
    for (d = 0; d < w->domain_count; d++) w->domains[d].kept_next = 0;
    if (!w->wall_count && !w->bodies.shaped) return 1;
    if ((!w->facets_valid && !demi_facets_weigh(w)) ||
        (!w->touching_valid && !demi_touching_reserve(w))) return 0;
    do {
        demi_parallel(w, w->desc.threads, w->domain_count, demi_domain_kept_touch);
        for (d = 0, again = 0; d < w->domain_count; d++) again |= w->domains[d].overflow & 16;
        if (again && !demi_kept_widen(w)) return 0;
    } while (again);
    return 1;
}

/* --- respond --- */

/* What a body adds to 1/M, 1/kg, where a stiffness follows masses: as light as any contact may find
   it, which is what the time step is chosen for. */
static double demi_give_at_most(const dem_world *w, int body) {
    const demi_shape *shape = demi_shape_of(w, body);
    return (double)w->bodies.inv_mass[body]/(shape ? shape->light : 1);
}
/* Coefficients of a contact, as yet without its slope. */
static void demi_kept_coefs(const dem_world *w, const demi_kept *k, dem_real *out) {
    const demi_wall *wall = k->b < 0 ? &w->walls[k->wall] : 0;
    const int grains = wall && demi_wall_is(wall, DEMI_BALLS);
    /* there a grain of a wall has mass */
    const int mill = w->desc.convention == DEM_CONVENTION_MILL;
    const double half = mill && grains ? 0.5 : 1, m = half*(double)k->m_eff;
    const int shaped = demi_shape_of(w, k->a) || (k->b >= 0 && demi_shape_of(w, k->b));
    const double give = shaped ? demi_give_at_most(w, k->a) +
        (k->b >= 0 ? demi_give_at_most(w, k->b) : 0) : 0;
    demi_coefficients(w, w->bodies.material[k->a] - 1,
                      wall ? wall->material : w->bodies.material[k->b] - 1, (double)k->r_eff, m,
                      shaped ? half/give : m, wall && !grains, out);
}
/* Velocity of a body at an arm: now, or its mean over the step. */
static dem_vec3 demi_velocity_at(const dem_real *v, const dem_real *spin, int body, dem_vec3 arm) {
    return demi_add(demi_at(v + 4*body), demi_cross(demi_at(spin + 4*body), arm));
}
static dem_vec3 demi_surface_at(const dem_pose *pose, dem_vec3 at) {
    return demi_add(pose->velocity, demi_cross(pose->spin, demi_sub(at, pose->position)));
}
/* What contact c takes over from the one it continues: memory, and coefficients where what they
   follow from is as it was (a sphere's on a wall always, a cluster's hardly ever: the mass that it
   feels there changes as it turns). Answers that one; c itself when it is new: then nothing has
   turned. */
DEM_INLINE const demi_kept *demi_kept_recall(const dem_world *w, const demi_kept *now,
                                             demi_kept *c) {
    const demi_kept *old = c->from < 0 ? c : now + c->from;
    /* a sphere's, which touch does not fetch */
    const dem_real m = c->m_eff > 0 ? c->m_eff : old != c ? old->m_eff : w->bodies.mass[c->a];
    const int fits = old != c && old->wall == c->wall &&
        !(old->coef_r < c->r_eff || old->coef_r > c->r_eff) &&
        !(old->coef_m < m || old->coef_m > m);
    c->m_eff = m;
    if (old != c) memcpy(c->memory, old->memory, sizeof c->memory);
    else memset(c->memory, 0, sizeof c->memory);
    if (fits) memcpy(c->coef, old->coef, sizeof c->coef);
    else demi_kept_coefs(w, c, c->coef);
    c->coef_r = c->r_eff;
    c->coef_m = c->m_eff;
    return old;
}
/* The contact as a law sees it; old: a step ago. surface: velocity of the wall there. */
static void demi_kept_fill(const dem_world *w, const demi_kept *k, const demi_kept *old,
                           dem_real dt, dem_contact *c, dem_vec3 *at, dem_vec3 *surface) {
    const dem_real *coef = k->coef, slope = k->slope;    /* m of overlap per m of approach */
    const int a = k->a, b = k->b;
    const dem_vec3 n = k->normal, half = demi_v(DEM_R(0.5), DEM_R(0.5), DEM_R(0.5));
    const dem_vec3 mid = demi_scale(demi_add(n, old->normal), half.x);
    const dem_vec3 mid_a = demi_scale(demi_add(k->arm_a, old->arm_a), half.x);
    dem_vec3 u = demi_velocity_at(w->bodies.vel, w->bodies.spin, a, k->arm_a);
    dem_vec3 gone, around, spin, spin_step;
    gone = demi_velocity_at(w->bodies.half_vel, w->bodies.half_spin, a, mid_a);
    if (b >= 0) {
        const dem_vec3 mid_b = demi_scale(demi_add(k->arm_b, old->arm_b), half.x);
        u = demi_sub(u, demi_velocity_at(w->bodies.vel, w->bodies.spin, b, k->arm_b));
        gone = demi_sub(gone, demi_velocity_at(w->bodies.half_vel, w->bodies.half_spin, b, mid_b));
        spin = demi_at(w->bodies.spin + 4*b);
        spin_step = demi_at(w->bodies.half_spin + 4*b);
        *at = *surface = demi_v(0, 0, 0);
    } else {
        const demi_wall *wall = &w->walls[k->wall];
        const dem_vec3 x = demi_add(demi_at(w->bodies.pos + 4*a), k->shift);
        /* where the contact was in the middle of the step */
        const dem_vec3 was =
            demi_add(mid_a, demi_sub(x, demi_scale(demi_at(w->bodies.half_vel + 4*a), dt/2)));
        *at = demi_add(x, k->arm_a);
        *surface = demi_surface_at(&wall->pose, *at);
        u = demi_sub(u, *surface);
        gone = demi_sub(gone, demi_surface_at(&wall->mid, was));
        spin = wall->pose.spin;
        spin_step = wall->mid.spin;
    }
    around = demi_add(demi_at(w->bodies.half_spin + 4*a), spin_step);
    memset(c, 0, sizeof *c);
    c->overlap = k->overlap;
    c->normal = n;
    c->closing_speed = demi_dot(u, n);
    c->slip = demi_sub(u, demi_scale(n, c->closing_speed));
    gone = demi_sub(gone, demi_scale(mid, demi_dot(gone, mid)));
    c->slip_step = demi_sub(gone, demi_scale(n, demi_dot(gone, n)));
    c->spin = demi_sub(demi_at(w->bodies.spin + 4*a), spin);
    c->spin_step = demi_sub(demi_at(w->bodies.half_spin + 4*a), spin_step);
    c->dt = dt;
    if (dt > 0) {
        const dem_vec3 turn = demi_scale(demi_sub(n, old->normal), 1/dt);
        c->normal_rate = demi_sub(turn, demi_scale(n, demi_dot(turn, n)));
    }
    c->twist = demi_dot(around, n)/2;
    c->r_eff = k->r_eff;
    c->m_eff = k->m_eff;
    c->kn = slope*coef[DEMI_KN]; c->cn = slope*coef[DEMI_CN];
    c->kun = slope*coef[DEMI_K_UN]; c->kad = slope*coef[DEMI_K_AD];
    c->kt = coef[DEMI_KT]; c->ct = coef[DEMI_CT];
    c->friction = coef[DEMI_MU]; c->friction_static = coef[DEMI_MU_STATIC];
    c->rolling_friction = coef[DEMI_MU_ROLL];
    c->material_a = w->bodies.material[a];
    c->material_b = b >= 0 ? w->bodies.material[b] : w->walls[k->wall].material + 1;
    c->wall = b >= 0 ? 0 : k->wall + 1;
    demi_contact_choices(w, c);
    c->user = w->desc.law_user;
}
/* Whether the elastic force counts more, or less, than what dissipates; and that force, N. */
DEM_INLINE int demi_kept_lifted(const demi_kept *k) {
    return k->lift < k->share || k->lift > k->share || demi_dot(k->aside, k->aside) > 0;
}
static DEMI_APART dem_real demi_kept_still(const dem_world *w, const demi_kept *k,
                                          const dem_contact *c) {
    dem_real memory[DEMI_MEMORY];
    dem_contact still = *c;
    dem_contact_force f;
    memcpy(memory, k->memory, sizeof memory);
    still.closing_speed = 0;
    demi_law(w, &still, memory, &f);
    return f.normal;
}
DEM_INLINE void demi_force_add(dem_real *sum, dem_vec3 f) {
    sum[0] += f.x; sum[1] += f.y; sum[2] += f.z;
}
/* What a force at a place, with a moment, adds to its wall's sums. */
DEM_INLINE void demi_wall_sum_add(const dem_world *w, demi_wall_sum *sum, int wall, dem_vec3 at,
                              dem_vec3 force, dem_vec3 moment, dem_vec3 surface) {
    const dem_vec3 arm = demi_sub(at, w->walls[wall].motion.point);
    const dem_vec3 torque = demi_add(demi_cross(arm, force), moment);
    sum->force[0] -= (double)force.x; sum->force[1] -= (double)force.y;
    sum->force[2] -= (double)force.z;
    sum->torque[0] -= (double)torque.x; sum->torque[1] -= (double)torque.y;
    sum->torque[2] -= (double)torque.z;
    sum->power += (double)(demi_dot(force, surface) + demi_dot(moment, w->walls[wall].pose.spin));
    sum->contacts++;
}
/* grip: how often friction and rolling count, which may differ from the rest: demi_kept_lift. */
DEM_INLINE void demi_energy_add(demi_domain *domain, const dem_contact_energy *part, dem_real share,
                                dem_real grip) {
    domain->energy[DEMI_E_DASHPOT] += (double)(share*(part->dashpot + part->sag));
    domain->energy[DEMI_E_ELASTIC] += (double)(share*part->elastic);
    domain->energy[DEMI_E_SHEAR_WORK] += (double)(grip*part->shear_work);
    domain->energy[DEMI_E_SLIDE] += (double)(grip*part->slide);
    domain->energy[DEMI_E_SHEAR_STORED] += (double)(grip*part->shear_stored);
    domain->energy[DEMI_E_ROLL] += (double)(grip*part->roll);
}

/* A body that a contact will soon read and push. */
DEM_INLINE void demi_body_fetch(const dem_world *w, int body) {
    DEMI_FETCH(w->bodies.vel + 4*body);
    DEMI_FETCH(w->bodies.half_vel + 4*body);
    DEMI_FETCH(w->bodies.spin + 4*body);
    DEMI_FETCH(w->bodies.half_spin + 4*body);
    DEMI_FETCH(w->bodies.force + 4*body);
    DEMI_FETCH(w->bodies.torque + 4*body);
}
/* All contacts of one domain: law, forces on both ends, walls' sums, energies. */
static void demi_kept_respond(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    const dem_real dt = w->stage.forces_valid ? w->clock.dt : 0;
    const demi_kept *now = demi_kept_of(w, d);
    demi_wall_sum *sums = w->wall_sums + (size_t)d*(size_t)w->wall_count;
    int i;
    domain->kept_walls = 0;
    for (i = 0; i < domain->kept_next; i++) {
        demi_kept *c = w->kept_next + w->kept_first[d] + i;
        const int a = c->a, b = c->b;
        const demi_kept *old;
        dem_real press, still;
        dem_contact contact;
        dem_contact_force f;
        dem_vec3 at, surface, force, moment, moment_b;
        if (i + 2 < domain->kept_next) demi_body_fetch(w, c[2].a);
        old = demi_kept_recall(w, now, c);
        if (!(c->overlap > 0)) {                /* under way through a reduced hole */
            c->force = demi_v(0, 0, 0);
            domain->kept_walls += b < 0;
            continue;
        }
        demi_kept_fill(w, c, old, dt, &contact, &at, &surface);
        still = demi_kept_lifted(c) ? demi_kept_still(w, c, &contact) : 0;
        demi_law(w, &contact, c->memory, &f);
        press = c->share*f.normal + (c->lift - c->share)*still;
        force = demi_sub(demi_scale(f.tangent, c->grip), demi_scale(contact.normal, press));
        moment = moment_b = demi_scale(f.moment, c->grip);
        if (demi_dot(c->aside, c->aside) > 0) { /* between the ball and what it goes round */
            const dem_vec3 aside = demi_scale(c->aside, still);
            const dem_vec3 arm = demi_sub(demi_part_now(w, a, c->part_a).centre, c->arm_a);
            const dem_vec3 far = demi_sub(arm, demi_scale(contact.normal, 1/c->bend));
            force = demi_add(force, aside);
            moment = demi_add(moment, demi_cross(arm, aside));
            moment_b = demi_add(moment_b, demi_cross(far, aside));
        }
        c->force = force;
        demi_force_add(w->bodies.force + 4*a, force);
        demi_force_add(w->bodies.torque + 4*a, demi_add(demi_cross(c->arm_a, force), moment));
        if (c->inset < 1)
            demi_force_add(w->bodies.torque + 4*a, demi_scale(demi_cross(c->arm_a, contact.normal),
                                                             (1 - c->inset)*press));
        if (b >= 0) {
            const dem_vec3 back = demi_scale(demi_add(demi_cross(c->arm_b, force), moment_b), -1);
            if (c->send) {                      /* several may go by one near pair */
                demi_force_add(w->cross_force + 6*(size_t)(c->send - 1), demi_scale(force, -1));
                demi_force_add(w->cross_force + 6*(size_t)(c->send - 1) + 3, back);
            } else {
                demi_force_add(w->bodies.force + 4*b, demi_scale(force, -1));
                demi_force_add(w->bodies.torque + 4*b, back);
            }
            domain->contacts++;
        } else {
            demi_wall_sum_add(w, &sums[c->wall], c->wall, at, force, moment_b, surface);
            domain->kept_walls++;
        }
        domain->overlap = DEMI_MAX(domain->overlap, (double)c->deep);
        f.energy.elastic /= c->slope;           /* V = k overlap^2/2; the law was given k slope */
        f.energy.sag /= c->slope;
        demi_energy_add(domain, &f.energy, c->share, c->grip);
    }
}
/* Slots of far ends are summed into: cleared before. */
static void demi_kept_clear(dem_world *w, int d) {
    const demi_domain *domain = &w->domains[d];
    const int pairs = domain->near_shaped_end - domain->near_shaped_cross;
    if (pairs > 0)
        memset(w->cross_force + 6*((size_t)d*(size_t)w->cross.stride +
                                  (size_t)(domain->near_end - domain->near_cross)), 0,
               6*(size_t)pairs*sizeof(dem_real));
}

/* ---------------------------------------------------------------------------------------------
   >>integrators
   Kick, drift and the velocity a law will see. Between steps pos, vel, force belong to the same
   time t_n; half_vel is the mean velocity of the step that led there, v(t_n - dt/2). Each scheme
   is one function over a range of bodies; `synced` = 0 says the step before was not finished, so
   that its last half kick is still due (it is merged with the first one of this step: same
   arithmetic). Rotation runs along in the same scheme (position Verlet: leapfrog).
   >>add-integrator: an enum value, a function here, a row in demi_integrator_rows.
   --------------------------------------------------------------------------------------------- */
typedef struct demi_lane {           /* one body's translation or rotation */
    dem_real *v, *half, *f;          /* velocity, half-step velocity, force: 4 reals each */
    dem_real inv, g[3];              /* inverse mass or inertia; acceleration besides forces */
} demi_lane;

/* v(t + dt/2) = v(t - dt/2) + a dt, and what a law will see: v(t + dt), a taken as constant. */
DEM_INLINE void demi_kick_leapfrog(const demi_lane *b, dem_real h) {
    int k;
    for (k = 0; k < 3; k++) {
        const dem_real kick = (b->f[k]*b->inv + b->g[k])*h;
        const dem_real half = b->half[k] + 2*kick;
        b->half[k] = half;
        b->v[k] = half + kick;
    }
}
DEM_INLINE void demi_finish_half(const demi_lane *b, dem_real h) {
    int k;
    for (k = 0; k < 3; k++) b->v[k] = b->half[k] + (b->f[k]*b->inv + b->g[k])*h;
}

/* A body as the schemes see it, its motion and its spin alike: what does not move has 1/mass 0, and
   no weight. */
DEM_INLINE demi_lane demi_lane_move(const dem_world *w, int i) {
    demi_lane b;
    b.v = w->bodies.vel + 4*i; b.half = w->bodies.half_vel + 4*i; b.f = w->bodies.force + 4*i;
    b.inv = w->bodies.inv_mass[i];
    b.g[0] = b.inv > 0 ? w->desc.gravity.x : 0;
    b.g[1] = b.inv > 0 ? w->desc.gravity.y : 0;
    b.g[2] = b.inv > 0 ? w->desc.gravity.z : 0;
    return b;
}
DEM_INLINE demi_lane demi_lane_turn(const dem_world *w, int i) {
    demi_lane b;
    b.v = w->bodies.spin + 4*i; b.half = w->bodies.half_spin + 4*i; b.f = w->bodies.torque + 4*i;
    b.inv = w->bodies.inv_inertia[i];
    b.g[0] = b.g[1] = b.g[2] = 0;
    return b;
}

/* x(t+dt) = x + dt (v + a dt/2): kick half, drift, predict, later kick half. By rows of four, the
   last of which stays zero (in pos: the radius, which zero does not move): rows make vectors. */
static void demi_move_velocity_verlet(dem_world *w, int begin, int end, int turning) {
    const dem_real dt = w->clock.dt, h = (dem_real)w->clock.half_kick;
    const int synced = w->stage.synced;
    dem_real *DEMI_RESTRICT x = w->bodies.pos, *DEMI_RESTRICT v = w->bodies.vel,
        *DEMI_RESTRICT u = w->bodies.half_vel;
    const dem_real *DEMI_RESTRICT f = w->bodies.force, *DEMI_RESTRICT inv = w->bodies.inv_mass;
    dem_real g[4];
    int i, k;
    g[0] = w->desc.gravity.x; g[1] = w->desc.gravity.y; g[2] = w->desc.gravity.z; g[3] = 0;
    for (i = begin; i < end; i++) {
        const dem_real m = inv[i], free_fall = m > 0 ? DEM_R(1) : DEM_R(0);
        for (k = 4*i; k < 4*i + 4; k++) {
            const dem_real kick = (f[k]*m + g[k - 4*i]*free_fall)*h;
            const dem_real half = (synced ? v[k] : u[k] + kick) + kick;
            u[k] = half;
            v[k] = half + kick;
            x[k] += half*dt;
        }
    }
    if (!turning) return;
    v = w->bodies.spin; u = w->bodies.half_spin; f = w->bodies.torque; inv = w->bodies.inv_inertia;
    for (i = begin; i < end; i++)
        for (k = 4*i; k < 4*i + 4; k++) {
            const dem_real kick = f[k]*inv[i]*h, half = (synced ? v[k] : u[k] + kick) + kick;
            u[k] = half;
            v[k] = half + kick;
        }
}
/* v(t+dt/2) = v(t-dt/2) + a dt, x(t+dt) = x + v(t+dt/2) dt */
static void demi_move_leapfrog(dem_world *w, int begin, int end, int turning) {
    const dem_real dt = w->clock.dt, h = (dem_real)w->clock.half_kick;
    int i, k;
    for (i = begin; i < end; i++) {
        const demi_lane b = demi_lane_move(w, i);
        demi_kick_leapfrog(&b, h);
        for (k = 0; k < 3; k++) w->bodies.pos[4*i + k] += b.half[k]*dt;
    }
    if (!turning) return;
    for (i = begin; i < end; i++) {
        const demi_lane b = demi_lane_turn(w, i);
        demi_kick_leapfrog(&b, h);
    }
}
/* x(t+dt) = 2 x(t) - x(t-dt) + a dt^2 [ALK07] eq 2.3; v from differences, predicted with a */
static void demi_move_position_verlet(dem_world *w, int begin, int end, int turning) {
    const dem_real dt = w->clock.dt, h = (dem_real)w->clock.half_kick;
    int i, k;
    for (i = begin; i < end; i++) {
        const demi_lane b = demi_lane_move(w, i);
        for (k = 0; k < 3; k++) {
            const dem_real a = b.f[k]*b.inv + b.g[k], x = w->bodies.pos[4*i + k];
            const dem_real next = 2*x - w->bodies.last_pos[4*i + k] + a*dt*dt;
            b.half[k] = (next - x)/dt;
            b.v[k] = b.half[k] + a*h;
            w->bodies.last_pos[4*i + k] = x;
            w->bodies.pos[4*i + k] = next;
        }
    }
    if (!turning) return;
    for (i = begin; i < end; i++) {
        const demi_lane b = demi_lane_turn(w, i);
        demi_kick_leapfrog(&b, h);
    }
}
/* v(t+dt) = v + a dt, x(t+dt) = x + v(t+dt) dt */
static void demi_move_symplectic_euler(dem_world *w, int begin, int end, int turning) {
    const dem_real dt = w->clock.dt;
    int i, k;
    for (i = begin; i < end; i++) {
        const demi_lane b = demi_lane_move(w, i), s = demi_lane_turn(w, i);
        for (k = 0; k < 3; k++) {
            b.half[k] = b.v[k] += (b.f[k]*b.inv + b.g[k])*dt;
            w->bodies.pos[4*i + k] += b.v[k]*dt;
            if (turning) s.half[k] = s.v[k] += s.f[k]*s.inv*dt;
        }
    }
}
/* x(t+dt) = x + v(t) dt, v(t+dt) = v + a dt [MIL] 4.6 */
static void demi_move_forward_euler(dem_world *w, int begin, int end, int turning) {
    const dem_real dt = w->clock.dt;
    int i, k;
    for (i = begin; i < end; i++) {
        const demi_lane b = demi_lane_move(w, i), s = demi_lane_turn(w, i);
        for (k = 0; k < 3; k++) {
            b.half[k] = b.v[k];
            w->bodies.pos[4*i + k] += b.v[k]*dt;
            b.v[k] += (b.f[k]*b.inv + b.g[k])*dt;
            s.half[k] = s.v[k];
            if (turning) s.v[k] += s.f[k]*s.inv*dt;
        }
    }
}
static void demi_finish_nothing(dem_world *w, int begin, int end) { (void)w; (void)begin;
    (void)end; }
/* Velocities of the present time, for schemes that stand at the half step. */
static void demi_finish_halves(dem_world *w, int begin, int end) {
    const dem_real h = (dem_real)w->clock.half_kick;
    int i;
    for (i = begin; i < end; i++) {
        const demi_lane b = demi_lane_move(w, i), s = demi_lane_turn(w, i);
        demi_finish_half(&b, h);
        demi_finish_half(&s, h);
    }
}
/* What half_vel and half_spin must be before the first step from a state at t. */
static void demi_prime_body(dem_world *w, int i) {
    const dem_real dt = w->clock.dt, h = dt/2;
    const demi_lane b = demi_lane_move(w, i), s = demi_lane_turn(w, i);
    int k;
    for (k = 0; k < 3; k++) {
        const dem_real a = b.f[k]*b.inv + b.g[k];
        b.half[k] = b.v[k] - a*h;
        if (w->bodies.backward) w->bodies.last_pos[4*i + k] = w->bodies.pos[4*i + k] - b.half[k]*dt;
        s.half[k] = s.v[k] - s.f[k]*s.inv*h;
    }
    if (w->bodies.shaped && w->bodies.shape[i])
        demi_put(w->bodies.angular + 4*i,
                 demi_sub(demi_angular_of(w, i), demi_scale(demi_at(w->bodies.torque + 4*i), h)));
}
static void demi_prime(dem_world *w) {
    int i;
    for (i = 0; i < w->bodies.count; i++) demi_prime_body(w, i);
    w->stage.primed = 1;
}
/* --- rotation. A sphere's spin runs along in the scheme of its translation; its orientation, when
       somebody asked for it, follows. A body that is not a sphere keeps its angular momentum in the
       world's frame, L(t - dt/2), which torques kick: L(t + dt/2) = L(t - dt/2) + T(t) dt. In
       between it flies free: from q(t) with L to q(t + dt), by one of the functions below; free
       flight leaves L as it is, to the bit. What a law sees: half_spin, the mean over the flight,
       and spin, predicted with the last torque. All are of second order under torques. Checked by
       tests of rotation (free flight against elliptic functions, order, tops). --- */

/* q turned by the rotation vector v of the body's frame (rad), |v| < 2: q exp(v/2), by series to
   1e-12. */
DEM_INLINE dem_quat demi_quat_spin(dem_quat q, dem_vec3 v) {
    const dem_real x = demi_dot(v, v)*DEM_R(0.25);         /* (half angle)^2 */
    /* cos and half of sin x/x; products with constants, which quotients would not become */
    const dem_real c = 1 + x*(DEM_R(-1.0/2) + x*(DEM_R(1.0/24) + x*(DEM_R(-1.0/720) +
        x*(DEM_R(1.0/40320) + x*(DEM_R(-1.0/3628800) + x*DEM_R(1.0/479001600))))));
    const dem_real s = DEM_R(0.5) + x*(DEM_R(-1.0/12) + x*(DEM_R(1.0/240) + x*(DEM_R(-1.0/10080) +
        x*(DEM_R(1.0/725760) + x*(DEM_R(-1.0/79833600) + x*DEM_R(1.0/12454041600.0))))));
    return dem_quat_times(q, dem_quat_make(c, s*v.x, s*v.y, s*v.z));
}
/* As demi_quat_unit, for what is nearly one, in kernels. */
DEM_INLINE dem_quat demi_quat_again(dem_quat q) {
    const dem_real l = 1/DEMI_SQRT(q.w*q.w + q.x*q.x + q.y*q.y + q.z*q.z);
    return dem_quat_make(q.w*l, q.x*l, q.y*l, q.z*l);
}
/* SPIRAL [SPI24], with angular momentum kept. There w goes from one half step to the next by a
   third order Runge-Kutta step with the torque in it, and q by q exp(dt w/2); both lose L a little
   every step. Here the torque is in the kick alone, and the flight is that of a free body: Taylor's
   series of w to third order, w' = I^-1 (I w x w), give its mean and its end,
       mean = w + h w'/2 + h^2 w''/6 + h^3 w'''/24,   end = w + h w' + h^2 w''/2 + h^3 w'''/6;
   q goes by the mean and the first term of Magnus, h (w x end)/12; then by the small rotation that
   puts I end where R^T L is: two of three errors of q are gone, and L, |q| are exact. Free flight:
   order 3 in q; error 10 times smaller than SPIRAL's at |w| h = .1, energy drift 9 times
   (docs/shapes.md). I, inv: principal moments, their inverses; answers the mean, in the body's
   frame. */
DEM_INLINE dem_vec3 demi_flight_spiral(dem_quat *q, dem_vec3 L, dem_vec3 I, dem_vec3 inv,
                                       dem_real h) {
    const dem_vec3 m = dem_quat_unrotate(*q, L);
    const dem_vec3 w = demi_v(m.x*inv.x, m.y*inv.y, m.z*inv.z);
    const dem_vec3 a = demi_v((I.y - I.z)*inv.x, (I.z - I.x)*inv.y, (I.x - I.y)*inv.z);
    const dem_vec3 w1 = demi_v(a.x*w.y*w.z, a.y*w.z*w.x, a.z*w.x*w.y);
    const dem_vec3 w2 = demi_v(a.x*(w1.y*w.z + w.y*w1.z), a.y*(w1.z*w.x + w.z*w1.x),
                               a.z*(w1.x*w.y + w.x*w1.y));
    const dem_vec3 w3 = demi_v(a.x*(w2.y*w.z + 2*w1.y*w1.z + w.y*w2.z),
                               a.y*(w2.z*w.x + 2*w1.z*w1.x + w.z*w2.x),
                               a.z*(w2.x*w.y + 2*w1.x*w1.y + w.x*w2.y));
    const dem_real ll = demi_dot(L, L);
    dem_vec3 mean, end, g, c, magnus;
    end = demi_scale(demi_add(w2, demi_scale(w3, h*DEM_R(1.0/3))), h*h*DEM_R(0.5));
    mean = demi_scale(demi_add(w2, demi_scale(w3, h*DEM_R(0.25))), h*h*DEM_R(1.0/6));
    end = demi_add(w, demi_add(demi_scale(w1, h), end));
    mean = demi_add(w, demi_add(demi_scale(w1, h*DEM_R(0.5)), mean));
    magnus = demi_scale(demi_cross(w, end), h*DEM_R(1.0/12));
    *q = demi_quat_spin(*q, demi_scale(demi_add(mean, magnus), h));
    end = demi_v(I.x*end.x, I.y*end.y, I.z*end.z);
    g = dem_quat_unrotate(*q, L);
    c = demi_scale(demi_cross(end, g), ll > DEMI_TINY ? DEM_R(0.5)/ll : 0);
    *q = demi_quat_again(dem_quat_times(*q, dem_quat_make(1, c.x, c.y, c.z)));
    return demi_add(mean, magnus);
}
/* [FIN92], which [RUB15] eq 17 to 21 uses with w for L (the same for spheroids that do not spin
   about their axis): half an Euler step for q at the middle, w there from L, a whole step with
   that. */
static dem_vec3 demi_flight_fincham(dem_quat *q, dem_vec3 L, dem_vec3 I, dem_real h) {
    const dem_quat start = *q;
    dem_vec3 m = dem_quat_unrotate(start, L), w = demi_v(m.x/I.x, m.y/I.y, m.z/I.z);
    dem_quat mid, by;
    by = dem_quat_times(start, dem_quat_make(0, w.x*h/4, w.y*h/4, w.z*h/4));
    mid = demi_quat_unit(dem_quat_make(start.w + by.w, start.x + by.x, start.y + by.y,
                                       start.z + by.z));
    m = dem_quat_unrotate(mid, L);
    w = demi_v(m.x/I.x, m.y/I.y, m.z/I.z);
    by = dem_quat_times(mid, dem_quat_make(0, w.x*h/2, w.y*h/2, w.z*h/2));
    *q = demi_quat_unit(dem_quat_make(start.w + by.w, start.x + by.x, start.y + by.y,
                                      start.z + by.z));
    return dem_quat_unrotate(start, dem_quat_rotate(mid, w));
}
/* NO_SQUISH's splitting [DLM97]: free rotation about x, y, z, y, x in turn, each exact; symplectic,
   so that energy swings and does not drift. */
static dem_vec3 demi_flight_splitting(dem_quat *q, dem_vec3 L, dem_vec3 I, dem_real h) {
    static const int order[5] = {0, 1, 2, 1, 0};
    const dem_quat start = *q;
    dem_vec3 m = dem_quat_unrotate(start, L), w0 = demi_v(m.x/I.x, m.y/I.y, m.z/I.z), w1;
    int k;
    for (k = 0; k < 5; k++) {
        const double step = (double)(k == 2 ? h : h/2);
        const double rate = order[k] == 0 ? (double)(m.x/I.x) : order[k] == 1 ? (double)(m.y/I.y)
            : (double)(m.z/I.z);
        const dem_real c = (dem_real)cos(rate*step/2), s = (dem_real)sin(rate*step/2);
        const dem_quat r = dem_quat_make(c, order[k] == 0 ? s : 0, order[k] == 1 ? s : 0,
                                         order[k] == 2 ? s : 0);
        *q = dem_quat_times(*q, r);
        m = dem_quat_unrotate(r, m);
    }
    *q = demi_quat_unit(*q);
    m = dem_quat_unrotate(*q, L);
    w1 = demi_v(m.x/I.x, m.y/I.y, m.z/I.z);
    return demi_scale(demi_add(w0, dem_quat_unrotate(start, dem_quat_rotate(*q, w1))), DEM_R(0.5));
}
/* Spin of a body with angular momentum L. */
DEM_INLINE dem_vec3 demi_spin_of(dem_quat q, dem_vec3 L, dem_vec3 inv) {
    const dem_vec3 m = dem_quat_unrotate(q, L);
    return dem_quat_rotate(q, demi_v(m.x*inv.x, m.y*inv.y, m.z*inv.z));
}

/* Bodies that turn, a tile at a time: rows of numbers, so that compilers make vectors of it. */
typedef struct demi_turning {
    dem_real q[4][DEMI_ROW], L[3][DEMI_ROW], T[3][DEMI_ROW], I[4][DEMI_ROW];
    dem_real half[3][DEMI_ROW], spin[3][DEMI_ROW];
    dem_real speed2[DEMI_ROW], change2[DEMI_ROW];        /* (m/s)^2, at the moment_arm's end */
    dem_real rate2[DEMI_ROW];                            /* (rad/s)^2 */
} demi_turning;
/* One body of the tile: kick L, fly, and say what a law will see and how fast it was. */
DEM_INLINE void demi_turning_fly(demi_turning *t, int l, int rotation, dem_real dt) {
    dem_quat q = dem_quat_make(t->q[0][l], t->q[1][l], t->q[2][l], t->q[3][l]), start = q;
    const dem_vec3 T = demi_v(t->T[0][l], t->T[1][l], t->T[2][l]);
    const dem_vec3 I = demi_v(t->I[0][l], t->I[1][l], t->I[2][l]);
    const dem_vec3 inv = demi_v(1/I.x, 1/I.y, 1/I.z);
    const dem_vec3 L = demi_v(t->L[0][l] + T.x*dt, t->L[1][l] + T.y*dt, t->L[2][l] + T.z*dt);
    const dem_vec3 mean = rotation == DEM_ROTATION_SPIRAL ? demi_flight_spiral(&q, L, I, inv, dt)
        : rotation == DEM_ROTATION_FINCHAM ? demi_flight_fincham(&q, L, I, dt)
        : demi_flight_splitting(&q, L, I, dt);
    const dem_vec3 half = dem_quat_rotate(start, mean);
    const dem_vec3 spin = demi_spin_of(q, demi_add(L, demi_scale(T, dt/2)), inv);
    const dem_vec3 by = demi_sub(spin, half);   /* half a step's change */
    t->rate2[l] = demi_dot(half, half);
    t->speed2[l] = t->rate2[l]*t->I[3][l]*t->I[3][l];
    t->change2[l] = 4*demi_dot(by, by)*t->I[3][l]*t->I[3][l];
    t->q[0][l] = q.w; t->q[1][l] = q.x; t->q[2][l] = q.y; t->q[3][l] = q.z;
    t->L[0][l] = L.x; t->L[1][l] = L.y; t->L[2][l] = L.z;
    t->half[0][l] = half.x; t->half[1][l] = half.y; t->half[2][l] = half.z;
    t->spin[0][l] = spin.x; t->spin[1][l] = spin.y; t->spin[2][l] = spin.z;
}
/* The common one, without a question inside, so that it becomes vectors. */
DEMI_CLONES static void demi_turning_spiral(demi_turning *t, int count, dem_real dt) {
    int l, q;
    for (q = 0; q < count; q += DEMI_LANES) {
        DEMI_VECTOR
        for (l = 0; l < DEMI_LANES; l++) demi_turning_fly(t, q + l, DEM_ROTATION_SPIRAL, dt);
    }
}
/* Turns the bodies listed, at most a tile; notes how fast and by how much they changed. */
static void demi_orient_some(dem_world *w, demi_domain *domain, const int *who, int count) {
    const dem_real dt = w->clock.dt;
    demi_turning t;
    int l, e;
    const int full = (count + DEMI_LANES - 1)/DEMI_LANES*DEMI_LANES;
    dem_real turn = 0, speed = 0, rate = 0, check = 0;
    for (l = 0; l < full; l++) {                /* groups filled up with the last one */
        size_t i = 4*(size_t)who[DEMI_MIN(l, count - 1)];
        DEMI_ONE_BY_ONE(i);
        for (e = 0; e < 4; e++) t.q[e][l] = w->bodies.orient[i + (size_t)e];
        for (e = 0; e < 4; e++) t.I[e][l] = w->bodies.moment[i + (size_t)e];
        for (e = 0; e < 3; e++) t.L[e][l] = w->bodies.angular[i + (size_t)e];
        for (e = 0; e < 3; e++) t.T[e][l] = w->bodies.torque[i + (size_t)e];
    }
    if (w->desc.rotation == DEM_ROTATION_SPIRAL) demi_turning_spiral(&t, full, dt);
    else for (l = 0; l < count; l++) demi_turning_fly(&t, l, (int)w->desc.rotation, dt);
    for (l = 0; l < count; l++) {
        size_t i = 4*(size_t)who[l];
        DEMI_ONE_BY_ONE(i);
        for (e = 0; e < 4; e++) w->bodies.orient[i + (size_t)e] = t.q[e][l];
        for (e = 0; e < 3; e++) w->bodies.angular[i + (size_t)e] = t.L[e][l];
        for (e = 0; e < 3; e++) w->bodies.half_spin[i + (size_t)e] = t.half[e][l];
        for (e = 0; e < 3; e++) w->bodies.spin[i + (size_t)e] = t.spin[e][l];
        if (w->bodies.centres_valid &&
            w->shapes[w->bodies.shape[who[l]] - 1].count) demi_centres_rotate(w, who[l]);
        turn = DEMI_MAX(turn, t.change2[l]);
        speed = DEMI_MAX(speed, t.speed2[l]);
        rate = DEMI_MAX(rate, t.rate2[l]);
        check += t.rate2[l];
    }
    domain->turn_rate = DEMI_MAX(domain->turn_rate, (double)rate);
    domain->turn = DEMI_MAX(domain->turn, (double)turn);
    domain->turn_speed = DEMI_MAX(domain->turn_speed, (double)speed);
    domain->check += (double)check;
}
/* Orientations of bodies begin .. end - 1 over one step, and spins of those that are not spheres.
   */
static void demi_orient_move(dem_world *w, demi_domain *domain, int begin, int end) {
    const dem_real dt = w->clock.dt;
    int who[DEMI_TILE], count = 0, i;
    for (i = begin; i < end; i++) {
        if (w->bodies.inv_mass[i] <= 0) continue;
        if (w->bodies.shape[i]) {
            who[count++] = i;
            if (count == DEMI_TILE) { demi_orient_some(w, domain, who, count); count = 0; }
        } else if (w->desc.orientations) {
            const dem_quat q = demi_quat_at(w->bodies.orient + 4*i);
            const dem_vec3 by = demi_scale(demi_at(w->bodies.half_spin + 4*i), dt);
            demi_quat_put(w->bodies.orient + 4*i,
                          demi_quat_again(demi_quat_spin(q, dem_quat_unrotate(q, by))));
        }
    }
    if (count) demi_orient_some(w, domain, who, count);
}
/* Spins at the full step, from angular momentum at the half step and the torque of now. */
static void demi_orient_finish(dem_world *w, int begin, int end) {
    const dem_real h = (dem_real)w->clock.half_kick;
    int i;
    for (i = begin; i < end; i++)
        if (w->bodies.shape[i] && w->bodies.inv_mass[i] > 0) {
            const dem_vec3 I = demi_at(w->bodies.moment + 4*i);
            demi_put(w->bodies.spin + 4*i, demi_spin_of(demi_quat_at(w->bodies.orient + 4*i),
                demi_add(demi_at(w->bodies.angular + 4*i),
                         demi_scale(demi_at(w->bodies.torque + 4*i), h)),
                demi_v(1/I.x, 1/I.y, 1/I.z)));
        }
}

typedef struct demi_integrator_row {
    const char *name;
    void (*move)(dem_world *w, int begin, int end, int turning);
    void (*finish)(dem_world *w, int begin, int end);
    int order;
    int backward;                  /* it needs last_pos, the places of one step ago */
} demi_integrator_row;
static const demi_integrator_row demi_integrator_rows[] = {     /* in the order of dem_integrator */
    {"velocity Verlet", demi_move_velocity_verlet, demi_finish_halves, 2, 0},
    {"forward Euler", demi_move_forward_euler, demi_finish_nothing, 1, 0},
    {"symplectic Euler", demi_move_symplectic_euler, demi_finish_nothing, 1, 0},
    {"position Verlet", demi_move_position_verlet, demi_finish_halves, 2, 1},
    {"leapfrog", demi_move_leapfrog, demi_finish_halves, 2, 0},
};
enum { DEMI_INTEGRATORS = (int)(sizeof demi_integrator_rows/sizeof *demi_integrator_rows) };

static void demi_domain_finish(dem_world *w, int d) {
    demi_integrator_rows[w->desc.integrator].finish(w, w->domains[d].begin, w->domains[d].end);
    if (w->bodies.shaped) demi_orient_finish(w, w->domains[d].begin, w->domains[d].end);
}

/* Completes the half kick that a step leaves open: velocities are then those of the present time.
   */
static void demi_finish(dem_world *w) {
    if (w->stage.synced) return;
    demi_parallel(w, w->desc.threads, w->domain_count, demi_domain_finish);
    w->stage.synced = 1;
}

/* ---------------------------------------------------------------------------------------------
   >>ledger
   Where the energy went. Laws add what they dissipate and store; moves add the work of gravity and
   fields; walls the work they do. The springs in the tangent planes are the odd one out: what they
   took in and neither hold nor lost to sliding was dissipated by the shear dashpot, or with the
   contact.
   --------------------------------------------------------------------------------------------- */
static double demi_sum_energy(const dem_world *w, int what) {
    double sum = 0;
    int d;
    for (d = 0; d < w->domain_count; d++) sum += w->domains[d].energy[what];
    return sum;
}
/* J, of all that moves. */
static void demi_kinetic(const dem_world *w, double *kinetic, double *rotational) {
    int i;
    *kinetic = *rotational = 0;
    for (i = 0; i < w->bodies.count; i++) {
        const dem_real *v = w->bodies.vel + 4*i;
        const double m = (double)w->bodies.mass[i];
        if (w->bodies.inv_mass[i] <= 0) continue;
        *kinetic += m*((double)v[0]*(double)v[0] + (double)v[1]*(double)v[1] +
                       (double)v[2]*(double)v[2])/2;
        *rotational += (double)demi_dot(demi_angular_of(w, i), demi_at(w->bodies.spin + 4*i))/2;
    }
}
/* After a force evaluation: adds the domains' flows to the totals; stored energies replace the
   last. */
static void demi_ledger_book(dem_world *w) {
    static const int flows[] = {DEMI_E_DASHPOT, DEMI_E_SHEAR_WORK, DEMI_E_SLIDE, DEMI_E_ROLL,
                                DEMI_E_FORCE};
    double walls = 0;
    size_t i;
    for (i = 0; i < sizeof flows/sizeof *flows; i++) {
        const double part = demi_sum_energy(w, flows[i]);
        w->booked.energy[flows[i]] += part;
        if (flows[i] == DEMI_E_FORCE) w->booked.throughput += fabs(part);
    }
    w->booked.energy[DEMI_E_ELASTIC] = demi_sum_energy(w, DEMI_E_ELASTIC);
    w->booked.energy[DEMI_E_SHEAR_STORED] = demi_sum_energy(w, DEMI_E_SHEAR_STORED);
    for (i = 0; i < (size_t)w->wall_count;
         i++) walls += (double)w->walls[i].loads.power*(w->stage.forces_valid
                                                           ? (double)w->clock.dt : 0);
    w->booked.energy[DEMI_E_WALLS] += walls;
    w->booked.throughput += fabs(walls);
}
DEM_API dem_ledger dem_ledger_get(const dem_world *w) {
    dem_ledger l;
    memset(&l, 0, sizeof l);
    if (!w || !w->desc.ledger) return l;
    demi_kinetic(w, &l.kinetic, &l.rotational);
    l.elastic = w->booked.energy[DEMI_E_ELASTIC] + w->booked.energy[DEMI_E_SHEAR_STORED];
    l.gravity = w->booked.energy[DEMI_E_GRAVITY];
    l.walls = w->booked.energy[DEMI_E_WALLS];
    l.force = w->booked.energy[DEMI_E_FORCE];
    l.inserted = w->booked.inserted;
    l.removed = w->booked.removed;
    l.normal = w->booked.energy[DEMI_E_DASHPOT];
    l.slide = w->booked.energy[DEMI_E_SLIDE];
    l.tangent = w->booked.energy[DEMI_E_SHEAR_WORK] - w->booked.energy[DEMI_E_SLIDE] -
        w->booked.energy[DEMI_E_SHEAR_STORED];
    l.rolling = w->booked.energy[DEMI_E_ROLL];
    l.throughput = w->booked.throughput + w->booked.inserted;
    l.residual = l.kinetic + l.rotational + l.elastic - l.gravity - l.walls - l.force -
        l.inserted + l.removed +
                 l.normal + l.slide + l.tangent + l.rolling;
    return l;
}
DEM_API dem_totals dem_totals_get(const dem_world *w) {
    dem_totals t;
    int i;
    memset(&t, 0, sizeof t);
    if (!w) return t;
    demi_kinetic(w, &t.kinetic, &t.rotational);
    for (i = 0; i < w->bodies.count; i++) {
        const double m = (double)w->bodies.mass[i];
        dem_real own[3];
        double x[3], v[3];
        int k;
        if (w->bodies.inv_mass[i] <= 0) continue;
        demi_put(own, demi_angular_of(w, i));
        for (k = 0; k < 3; k++) {
            x[k] = (double)w->bodies.pos[4*i + k];
            v[k] = (double)w->bodies.vel[4*i + k];
        }
        t.mass += m;
        for (k = 0; k < 3; k++) {
            t.centre[k] += m*x[k];
            t.momentum[k] += m*v[k];
            t.angular[k] += m*(x[(k + 1)%3]*v[(k + 2)%3] - x[(k + 2)%3]*v[(k + 1)%3]) +
                (double)own[k];
        }
    }
    for (i = 0; i < 3 && t.mass > 0; i++) t.centre[i] /= t.mass;
    return t;
}

/* ---------------------------------------------------------------------------------------------
   >>placing
   Where new grains find room: one engine for fills, packings and feeds. A region says which places
   there are: a box, of which an axis that holds a whole period has no faces, a cylinder in it, a
   function. A crowd says who is near: spheres in a tree of boxes, halved along the longest side
   whenever one holds more than a few; each box knows the largest radius in it, so that what cannot
   be near is passed over whole, whatever the mixture (1:100 and more), and nobody looks at every
   body for every place. Walls are asked through their own cells. Places are tried at random, one
   after the other, none moves another away [random sequential addition], by random numbers of their
   own: the same seed gives the same places.
   --------------------------------------------------------------------------------------------- */
enum { DEMI_CROWD_LEAF = 8, DEMI_CROWD_DEPTH = 60 };
/* Tries for one grain: places that were taken, and places that the region does not have. */
enum { DEMI_FILL_TRIES = 2000, DEMI_FILL_OUTSIDE = 200000 };
/* Lattice places that a packing looks at. */
#define DEMI_PACK_MOST 3e8

typedef struct demi_node {
    int32_t child;                 /* the first of its two halves; 0: a leaf */
    int32_t first, count;          /* of a leaf: spheres, from `first` on by `next` */
    dem_real largest;              /* m, largest radius below it */
} demi_node;
typedef struct demi_sphere { dem_vec3 at; dem_real radius; int32_t next, body; } demi_sphere;
typedef struct demi_crowd {
    demi_periods p;
    double lo[3], size[3];         /* of the tree's box; on a periodic axis the whole period */
    int count, nodes;
} demi_crowd;
/* A box on the way down the tree. */
typedef struct demi_nook { int32_t node; double lo[3], size[3]; } demi_nook;

static demi_sphere *demi_crowd_spheres(const dem_world *w) {
    return w->crowd;
}
static demi_node *demi_crowd_nodes(const dem_world *w) {
    return w->crowd_nodes;
}
static int demi_longest(const double *size) {
    const int k = size[1] > size[0];
    return size[2] > size[k] ? 2 : k;
}
/* The half of a nook that is below (0) or above (1) its middle. */
static demi_nook demi_nook_half(const demi_nook *n, int32_t child, int upper) {
    demi_nook h = *n;
    const int k = demi_longest(n->size);
    h.node = child + upper;
    h.size[k] = n->size[k]/2;
    if (upper) h.lo[k] += h.size[k];
    return h;
}
static int demi_nook_upper(const demi_nook *n, dem_vec3 x) {
    const int k = demi_longest(n->size);
    return (double)(k == 0 ? x.x : k == 1 ? x.y : x.z) >= n->lo[k] + n->size[k]/2;
}
/* The whole of the tree's box. */
static demi_nook demi_crowd_root(const demi_crowd *c) {
    demi_nook n;
    n.node = 0;
    memcpy(n.lo, c->lo, sizeof n.lo);
    memcpy(n.size, c->size, sizeof n.size);
    return n;
}
/* Sphere i, first in the leaf's chain. */
static void demi_leaf_put(demi_node *leaf, demi_sphere *all, int32_t i) {
    all[i].next = leaf->first;
    leaf->first = i;
    leaf->count++;
    leaf->largest = DEMI_MAX(leaf->largest, all[i].radius);
}
/* Halves a leaf. 0 when memory ran out; it is as it was. */
static int demi_leaf_split(dem_world *w, demi_crowd *c, const demi_nook *at) {
    demi_sphere *all = demi_crowd_spheres(w);
    demi_node *nodes;
    int32_t i, next;
    int k;
    if (!DEMI_GROW(w, w->crowd_nodes, (size_t)c->nodes + 2)) return 0;
    nodes = demi_crowd_nodes(w);
    nodes[at->node].child = c->nodes;
    for (k = 0; k < 2; k++) {
        demi_node *half = nodes + c->nodes++;
        half->child = half->count = 0;
        half->first = -1;
        half->largest = 0;
    }
    for (i = nodes[at->node].first; i >= 0; i = next) {
        next = all[i].next;
        demi_leaf_put(nodes + nodes[at->node].child + demi_nook_upper(at, all[i].at), all, i);
    }
    return 1;
}
/* One more sphere in the crowd. What stands outside the tree's box counts to the nearest leaf,
   which is never farther from a place in the box than the sphere is. body: its index, if it is one
   already. 0 when memory ran out. */
static int demi_crowd_put(dem_world *w, demi_crowd *c, dem_vec3 x, dem_real radius, int body) {
    demi_nook at = demi_crowd_root(c);
    demi_sphere *s;
    demi_node *node;
    int depth = 0;
    if (!DEMI_GROW(w, w->crowd, (size_t)c->count + 1)) return 0;
    s = demi_crowd_spheres(w) + c->count;
    s->at = demi_place_of(&c->p, x);
    s->radius = radius;
    s->body = body;
    for (;;) {
        node = demi_crowd_nodes(w) + at.node;
        node->largest = DEMI_MAX(node->largest, radius);
        if (!node->child && node->count >= DEMI_CROWD_LEAF && depth < DEMI_CROWD_DEPTH &&
            !demi_leaf_split(w, c, &at)) return 0;
        node = demi_crowd_nodes(w) + at.node;
        if (!node->child) break;
        at = demi_nook_half(&at, node->child, demi_nook_upper(&at, s->at));
        depth++;
    }
    demi_leaf_put(node, demi_crowd_spheres(w), c->count++);
    return 1;
}
/* How far a place is from a nook, squared; less where that takes no thought. */
static double demi_nook_far2(const demi_crowd *c, const demi_nook *n, const double *x) {
    double d2 = 0;
    int k;
    for (k = 0; k < 3; k++) {
        const double below = n->lo[k] - x[k], above = x[k] - n->lo[k] - n->size[k];
        const double period = (double)c->p.period[k];
        double d = below > above ? below : above;
        if (!(d > 0)) continue;
        if (period > 0) {                       /* or the other way round */
            const double round = period - n->size[k] - d;
            d = round < 0 ? 0 : DEMI_MIN(d, round);
        }
        d2 += d*d;
    }
    return d2;
}
/* How many of the crowd a sphere overlaps, and the bodies they are; ends with the first that
   `found` has no room for. Its centre is in the tree's box. */
static int demi_crowd_look(const dem_world *w, const demi_crowd *c, dem_vec3 centre,
                           dem_real radius, int32_t *found, int room) {
    const demi_sphere *all = demi_crowd_spheres(w);
    const demi_node *nodes = demi_crowd_nodes(w);
    const dem_vec3 at = demi_place_of(&c->p, centre);
    demi_nook stack[DEMI_CROWD_DEPTH + 2];
    double x[3];
    int top = 0, count = 0, i;
    if (!c->count) return 0;
    x[0] = (double)at.x; x[1] = (double)at.y; x[2] = (double)at.z;
    stack[top++] = demi_crowd_root(c);
    while (top) {
        const demi_nook n = stack[--top];
        const demi_node *node = nodes + n.node;
        const double cut = (double)(radius + node->largest);
        if (demi_nook_far2(c, &n, x) >= cut*cut) continue;
        if (node->child) {                      /* the half it is in comes first */
            const int upper = demi_nook_upper(&n, at);
            stack[top++] = demi_nook_half(&n, node->child, !upper);
            stack[top++] = demi_nook_half(&n, node->child, upper);
            continue;
        }
        for (i = node->first; i >= 0; i = all[i].next) {
            const dem_vec3 d = demi_nearest(&c->p, demi_sub(all[i].at, at));
            const dem_real s = all[i].radius + radius;
            if (!(demi_dot(d, d) < s*s)) continue;
            if (count++ == room) return count;
            found[count - 1] = all[i].body;
        }
    }
    return count;
}
/* Does a sphere overlap nobody in the crowd? */
static int demi_crowd_free(const dem_world *w, const demi_crowd *c, dem_vec3 centre,
                           dem_real radius) {
    return !demi_crowd_look(w, c, centre, radius, 0, 0);
}

/* --- regions --- */

/* Where centres may be, ready for drawing. */
typedef struct demi_region {
    dem_vec3 lo;                   /* m */
    double size[3];
    int cylinder;                  /* 1 + the axis it is along; 0: all of the box */
    dem_inside_fn inside;
    void *user;
} demi_region;

/* Centres keep `off` (m) from the faces of the box. A box that holds a whole period has no faces
   on that axis. 0: there is no room. */
static int demi_region_make(const dem_world *w, const dem_region *from, double off,
                            demi_region *to) {
    const demi_periods p = demi_periods_of(w);
    dem_real lo[3], hi[3];
    int k, ok = 1;
    demi_put(lo, from->box.lo);
    demi_put(hi, from->box.hi);
    for (k = 0; k < 3; k++) {
        const double side = (double)hi[k] - (double)lo[k], period = (double)p.period[k];
        to->size[k] = side - 2*off;
        if (period > 0 && side >= period*(1 - 1e-6)) {
            to->size[k] = period;
            lo[k] = p.lo[k];
        } else lo[k] += (dem_real)off;
        if (k == 2 && w->desc.planar) {
            to->size[k] = 0;
            lo[k] = 0;
        }
        ok = ok && to->size[k] >= 0;
    }
    to->lo = demi_at(lo);
    to->cylinder = from->cylinder ? 1 + from->cylinder - 'x' : 0;
    to->inside = from->inside;
    to->user = from->user;
    return ok && demi_finite3(from->box.lo) && demi_finite3(from->box.hi);
}
/* The place that three numbers from 0 to 1 name. 0: not of the region. */
static int demi_region_at(const demi_region *g, const double *u, dem_real radius, dem_vec3 *x) {
    double round = 0;
    int k;
    for (k = 0; k < 3; k++)
        if (g->cylinder && g->cylinder != 1 + k) round += (2*u[k] - 1)*(2*u[k] - 1);
    if (round > 1) return 0;
    *x = demi_v(g->lo.x + (dem_real)(g->size[0]*u[0]), g->lo.y + (dem_real)(g->size[1]*u[1]),
                g->lo.z + (dem_real)(g->size[2]*u[2]));
    return !g->inside || g->inside(*x, radius, g->user);
}

/* Begins a crowd with the bodies that spheres of this radius in the region could overlap; one look
   at each body. p: the scene's, which a slab does not have. 0 when memory ran out. */
static int demi_crowd_begin(dem_world *w, demi_crowd *c, const demi_region *g, dem_real radius,
                            demi_periods p) {
    dem_vec3 mid;
    double half[3];
    demi_node *root;
    int i, k;
    c->p = p;
    demi_walls_repeat(w);
    c->count = 0;
    c->nodes = 1;
    if (!DEMI_GROW(w, w->crowd_nodes, 1)) return 0;
    root = demi_crowd_nodes(w);
    root->child = root->count = 0;
    root->first = -1;
    root->largest = 0;
    c->lo[0] = (double)g->lo.x; c->lo[1] = (double)g->lo.y; c->lo[2] = (double)g->lo.z;
    for (k = 0; k < 3; k++) half[k] = g->size[k]/2;
    mid = demi_v((dem_real)(c->lo[0] + half[0]), (dem_real)(c->lo[1] + half[1]),
                 (dem_real)(c->lo[2] + half[2]));
    for (k = 0; k < 3; k++) {
        c->size[k] = g->size[k];
        if (!(c->p.period[k] > 0)) continue;
        c->lo[k] = (double)c->p.lo[k];
        c->size[k] = (double)c->p.period[k];
    }
    for (i = 0; i < w->bodies.count; i++) {
        const dem_real r = w->bodies.pos[4*i + 3];
        const dem_vec3 d = demi_nearest(&c->p, demi_sub(demi_at(w->bodies.pos + 4*i), mid));
        /* a part in a thousand more: rounding must not lose a neighbour */
        const double s = 1.001*(double)(r + radius);
        if (fabs((double)d.x) > half[0]*1.001 + s || fabs((double)d.y) > half[1]*1.001 + s ||
            fabs((double)d.z) > half[2]*1.001 + s) continue;
        if (!demi_crowd_put(w, c, demi_at(w->bodies.pos + 4*i), r, i)) return 0;
    }
    return 1;
}
/* Its arrays go when the placing is done; feeds, which place again and again, keep theirs. */
static void demi_crowd_end(dem_world *w) {
    demi_free(w, w->crowd);
    demi_free(w, w->crowd_nodes);
    demi_free(w, w->crowd_turned);
    w->crowd = 0;
    w->crowd_nodes = 0;
    w->crowd_turned = 0;
}

/* --- walls --- */

/* Does a sphere touch none of the elements of a wall? at: in the wall's frame. */
static int demi_wall_clear(const demi_wall *wall, dem_vec3 at, dem_real radius) {
    const dem_real touch = radius*(DEMI_SINGLE ? DEM_R(0.9999) : DEM_R(0.999999999));
    const dem_vec3 out = demi_v(radius, radius, radius);
    int k, x, y, z, f[3], l[3];
    if (demi_wall_is(wall, DEMI_DRAWN)) at.z = 0;
    if (!wall->cell_start) {
        for (k = 0; k < wall->element_count; k++)
            if (demi_wall_distance(wall, k, at, radius) < touch) return 0;
        return 1;
    }
    demi_wall_cells(wall, demi_sub(at, out), demi_add(at, out), f, l);
    for (z = f[2]; z <= l[2]; z++)
        for (y = f[1]; y <= l[1]; y++)
            for (x = f[0]; x <= l[0]; x++) {
                const int cell = x + wall->cells[0]*(y + wall->cells[1]*z);
                for (k = wall->cell_start[cell]; k < wall->cell_start[cell + 1]; k++)
                    if (demi_wall_distance(wall, wall->cell_items[k], at, radius) < touch)
                        return 0;
            }
    return 1;
}
/* Does a sphere touch no wall, where walls are now? What is behind a plane or on the wrong side of
   a cylinder touches it; in a sieve's sheet there is no room, holes or not; the inside of a closed
   mesh is a place like any other. */
static int demi_walls_clear(const dem_world *w, dem_vec3 x, dem_real radius) {
    int j, a, b, c, f[3], l[3];
    for (j = 0; j < w->wall_count; j++) {
        const demi_wall *wall = &w->walls[j];
        if (wall->kind == DEMI_WALL_NONE) continue;
        demi_wall_images(w, wall, x, radius, f, l);
        for (c = f[2]; c <= l[2]; c++)
            for (b = f[1]; b <= l[1]; b++)
                for (a = f[0]; a <= l[0]; a++) {
                    const dem_vec3 at = demi_add(x, demi_wall_shift(w, a, b, c));
                    if (!demi_wall_clear(wall, demi_unrotate(wall->pose.rotation,
                                             demi_sub(at, wall->pose.position)), radius)) return 0;
                }
    }
    return 1;
}
static int demi_room_free(const dem_world *w, const demi_crowd *c, dem_vec3 x, dem_real radius) {
    return demi_crowd_free(w, c, x, radius) && demi_walls_clear(w, x, radius);
}

/* --- fills --- */

/* All orientations are equally likely (Shoemake 1992). */
static dem_quat demi_quat_random(uint64_t *state) {
    const double u = demi_uniform(state), a = 2*DEMI_PI*demi_uniform(state);
    const double b = 2*DEMI_PI*demi_uniform(state), r = sqrt(1 - u), s = sqrt(u);
    return dem_quat_make((dem_real)(r*sin(a)), (dem_real)(r*cos(a)), (dem_real)(s*sin(b)),
                         (dem_real)(s*cos(b)));
}
/* Adds what was placed in the crowd from sphere `first` on, all or nothing. 0 when memory ran
   out. */
static int demi_crowd_settle(dem_world *w, const demi_crowd *c, int first, int material,
                             int shape) {
    const demi_sphere *s = demi_crowd_spheres(w);
    const dem_real *q = w->crowd_turned;
    int i;
    if (!demi_list_drop(w) ||
        !demi_bodies_reserve(w, (size_t)w->bodies.count + (size_t)(c->count - first)) ||
        (shape >= 0 && !demi_orient_begin(w))) return 0;
    for (i = first; i < c->count; i++) {
        demi_body_append(w, material, s[i].radius, s[i].at);
        if (shape >= 0)
            demi_body_shape(w, w->bodies.count - 1, shape, 1,
                            demi_quat_at(q + 4*(size_t)(i - first)));
    }
    if (c->count > first) demi_scene_changed(w);
    return 1;
}
/* Finds places for up to `count` spheres, which join the crowd. Answers how many; -1: memory ran
   out. */
static int demi_fill_places(dem_world *w, demi_crowd *c, const demi_region *g, dem_real radius,
                            int turned, int count, uint64_t state) {
    int i, k;
    for (i = 0; i < count; i++) {
        int taken = 0, outside = 0;
        dem_vec3 x;
        for (;;) {
            double u[3];
            for (k = 0; k < 3; k++) u[k] = k == 2 && w->desc.planar ? 0 : demi_uniform(&state);
            if (!demi_region_at(g, u, radius, &x)) {
                if (++outside == DEMI_FILL_OUTSIDE) return i;
                continue;
            }
            if (demi_room_free(w, c, x, radius)) break;
            if (++taken == DEMI_FILL_TRIES) return i;
        }
        if (!demi_crowd_put(w, c, x, radius, -1)) return -1;
        if (!turned) continue;
        if (!DEMI_GROW(w, w->crowd_turned, 4*((size_t)i + 1))) return -1;
        demi_quat_put(w->crowd_turned + 4*(size_t)i, demi_quat_random(&state));
    }
    return count;
}
/* Fills a region with spheres, or with bodies of a shape (>= 0), whose bounding sphere has this
   radius. */
static int demi_fill(dem_world *w, const char *call, dem_material material, int shape,
                     dem_real radius, const dem_region *region, int count, uint64_t seed) {
    demi_region g;
    demi_crowd c;
    int m = 0, first, done;
    if (demi_material_index(w, call, material, &m) != DEM_OK) return 0;
    if (!(radius > 0) || !demi_finite(radius) || count < 0) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "%s: radius is %g m and count %d, must be > 0 and >= 0",
                  call, (double)radius, count);
        return 0;
    }
    if (shape < 0 ? demi_mass_refuse(w, call, m, radius, 0)
                 : demi_shape_mass_refuse(w, call, m, shape, 1, 0) ||
                   demi_walls_strange(w, call, shape)) return 0;
    if (region->cylinder && (region->cylinder < 'x' || region->cylinder > 'z')) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "%s: region.cylinder is %d, must be 'x', 'y' or 'z', the "
                  "axis it is along, or 0 for all of the box", call, region->cylinder);
        return 0;
    }
    if (!demi_place(region->box.lo) || !demi_place(region->box.hi) ||
        !demi_region_make(w, region, (double)radius, &g)) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "%s: the box is smaller than one sphere of radius %g m; "
                  "give lo below hi by at least a diameter", call, (double)radius);
        return 0;
    }
    done = demi_crowd_begin(w, &c, &g, radius, demi_periods_of(w)) ? 0 : -1;
    first = c.count;
    if (!done) done = demi_fill_places(w, &c, &g, radius, shape >= 0, count, seed);
    if (done >= 0 && !demi_crowd_settle(w, &c, first, m, shape)) done = -1;
    demi_crowd_end(w);
    if (done < 0) {
        demi_no_memory(w, call);
        return 0;
    }
    if (done < count)
        demi_fail(w, DEM_ERROR_ARGUMENT, "%s: %d of %d %s of radius %g m found a place in %d "
                  "tries each, free of other bodies and of walls; enlarge the %s, or %s", call,
                  done, count, shape < 0 ? "spheres" : "bodies with bounding spheres",
                  (double)radius, (int)DEMI_FILL_TRIES, region->inside ? "region" : "box", shape < 0
                  ? "pack them with dem_spheres_pack" : "place them yourself with dem_bodies_add");
    demi_built(w, call);                        /* fewer than asked: the answer says so */
    return done;
}
/* All of a box: no cylinder, no function. */
static dem_region demi_region_box(dem_box box) {
    dem_region region;
    memset(&region, 0, sizeof region);
    region.box = box;
    return region;
}
DEM_API int dem_spheres_fill(dem_world *w, dem_material material, dem_real radius, dem_box box,
                             int count, uint64_t seed) {
    const dem_region region = demi_region_box(box);
    if (demi_null(w, "dem_spheres_fill", w, "world")) return 0;
    return demi_fill(w, "dem_spheres_fill", material, -1, radius, &region, count, seed);
}
static int demi_shape_fill(dem_world *w, const char *call, dem_material material, dem_shape shape,
                          const dem_region *region, int count, uint64_t seed) {
    const int i = demi_shape_index(w, call, shape);
    if (i < 0) return 0;
    return demi_fill(w, call, material, i, w->shapes[i].radius, region, count, seed);
}
DEM_API int dem_bodies_fill(dem_world *w, dem_material material, dem_shape shape, dem_box box,
                            int count, uint64_t seed) {
    const dem_region region = demi_region_box(box);
    if (demi_null(w, "dem_bodies_fill", w, "world")) return 0;
    return demi_shape_fill(w, "dem_bodies_fill", material, shape, &region, count, seed);
}
DEM_API int dem_region_fill(dem_world *w, const dem_region *region, dem_material material,
                            dem_shape shape, dem_real radius, int count, uint64_t seed) {
    const char *call = "dem_region_fill";
    if (demi_null(w, call, region, "region")) return 0;
    return shape.id ? demi_shape_fill(w, call, material, shape, region, count, seed)
                    : demi_fill(w, call, material, -1, radius, region, count, seed);
}

/* --- packings --- */

/* Sphere (i, j, k) of a hexagonal close packing of spheres of radius r that starts at the origin:
   even and odd layers alternate. In a plane: a triangular lattice, k = 0. */
static dem_vec3 demi_pack_site(int64_t i, int64_t j, int64_t k, double r) {
    return demi_v((dem_real)(r*(double)(2*i + ((j + k) & 1))),
                  (dem_real)(r*sqrt(3.0)*((double)j + (double)(k & 1)/3.0)),
                  (dem_real)(r*(double)k*2*sqrt(6.0)/3));
}
typedef struct demi_lattice {
    dem_vec3 lo;                   /* m, the first place */
    double size[3], r;             /* m, how far the last one may be from it; half a pitch */
    dem_real radius;
    dem_inside_fn inside;
    void *user;
    int count;                     /* at most; 0: all */
    double looked;                 /* places looked at */
} demi_lattice;
/* Free places of the lattice, in layers along z, join the crowd's array (not its tree: they do not
   overlap each other). Answers how many; -1: memory ran out. */
static int demi_lattice_fill(dem_world *w, demi_crowd *c, demi_lattice *g) {
    const double slack = 1e-9*g->r;
    int64_t i, j, k;
    int done = 0;
    for (k = 0;; k++) {
        if ((double)demi_pack_site(0, 0, k, g->r).z > g->size[2] + slack ||
            (k > 0 && w->desc.planar)) return done;
        for (j = 0;; j++) {
            if ((double)demi_pack_site(0, j, k, g->r).y > g->size[1] + slack) break;
            for (i = 0;; i++) {
                const dem_vec3 s = demi_pack_site(i, j, k, g->r);
                const dem_vec3 x = demi_v(g->lo.x + s.x, g->lo.y + s.y,
                                          w->desc.planar ? 0 : g->lo.z + s.z);
                demi_sphere *to;
                if ((double)s.x > g->size[0] + slack) break;
                if (++g->looked > DEMI_PACK_MOST || c->count == INT_MAX/64) return done;
                if (g->inside && !g->inside(x, g->radius, g->user)) continue;
                if (!demi_room_free(w, c, x, g->radius*DEM_R(0.999999))) continue;
                if (!DEMI_GROW(w, w->crowd, (size_t)c->count + (size_t)done + 1)) return -1;
                to = demi_crowd_spheres(w) + c->count + done++;
                to->at = x;
                to->radius = g->radius;
                if (g->count && done == g->count) return done;
            }
        }
    }
}
/* About how many places a lattice has. */
static double demi_lattice_places(const dem_world *w, const demi_lattice *g) {
    const double rows = g->size[1]/(g->r*sqrt(3.0)) + 1, layers = g->size[2]/(g->r*1.633) + 1;
    return (g->size[0]/(2*g->r) + 1)*rows*(w->desc.planar ? 1 : layers);
}
/* A lattice in a box. 0: not one place. */
static int demi_lattice_make(const dem_world *w, dem_box box, dem_real radius, dem_real padding,
                             demi_region *room, demi_lattice *g) {
    const demi_periods p = demi_periods_of(w);
    const dem_region region = demi_region_box(box);
    dem_real lo[3];
    int k;
    memset(g, 0, sizeof *g);
    g->r = (double)radius + (double)padding/2;
    g->radius = radius;
    if (!demi_region_make(w, &region, (double)radius, room)) return 0;
    demi_put(lo, room->lo);
    for (k = 0; k < 3; k++) {                   /* round a period, the last keeps off the first */
        const int full = p.period[k] > 0 && room->size[k] >= (double)p.period[k];
        g->size[k] = room->size[k] - (full ? 2*g->r : 0);
        if (full) lo[k] += radius;
        if (!(g->size[k] >= 0)) return 0;
    }
    g->lo = demi_at(lo);
    return 1;
}
DEM_API int dem_spheres_pack(dem_world *w, dem_material material, dem_real radius, dem_real padding,
                             dem_box box, dem_inside_fn inside, void *user, int count) {
    const char *call = "dem_spheres_pack";
    demi_region room;
    demi_crowd c;
    demi_lattice g;
    int m = 0, first, done;
    if (demi_null(w, call, w, "world") || demi_material_index(w, call, material, &m) != DEM_OK)
        return 0;
    if (!(radius > 0) || !(padding >= 0) || !demi_finite(radius) || !demi_finite(padding) ||
        count < 0 || !demi_place(box.lo) || !demi_place(box.hi)) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "%s: radius %g, padding %g, count %d; must be > 0, >= 0, "
                  ">= 0 and the box finite", call, (double)radius, (double)padding, count);
        return 0;
    }
    if (demi_mass_refuse(w, call, m, radius, 0) ||
        !demi_lattice_make(w, box, radius, padding, &room, &g)) return 0;
    g.inside = inside; g.user = user; g.count = count;
    if (!count && !inside && demi_lattice_places(w, &g) > 1.1*(INT_MAX/64)) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "%s: the box has about %.3g places for spheres of radius "
                  "%g m, must be at most %d, which is what a world holds; make the box smaller or "
                  "give a count", call, demi_lattice_places(w, &g), (double)radius, INT_MAX/64);
        return 0;
    }
    done = demi_crowd_begin(w, &c, &room, radius, demi_periods_of(w)) ? 0 : -1;
    first = c.count;
    if (!done) done = demi_lattice_fill(w, &c, &g);
    c.count += DEMI_MAX(done, 0);
    if (done >= 0 && !demi_crowd_settle(w, &c, first, m, -1)) done = -1;
    demi_crowd_end(w);
    if (done < 0) {
        demi_no_memory(w, call);
        return 0;
    }
    if (g.looked > DEMI_PACK_MOST || c.count >= INT_MAX/64)
        demi_fail(w, DEM_ERROR_ARGUMENT, "%s: stopped after %.3g places, %d spheres of radius %g m "
                  "packed; a world holds %d bodies, and %g places are looked at: make the box "
                  "smaller", call, g.looked, done, (double)radius, INT_MAX/64, DEMI_PACK_MOST);
    demi_built(w, call);
    return done;
}

/* ---------------------------------------------------------------------------------------------
   >>feed
   Grains come in between two steps, joining the list of candidates (demi_list_join), and go out in
   the middle of one, when all have moved and a list is due. What a feed draws comes from its own
   random state in a fixed order: class, then place and velocity until a place is free. How much is
   due follows from the time alone. Who asks for room and puts grains in is told by a demi_feeder:
   here a world, in >>slabs-run all slabs.
   --------------------------------------------------------------------------------------------- */
enum { DEMI_FEED_TRIES = 40, DEMI_FEED_REST = 16 };  /* places tried; steps until the next try */
enum { DEMI_FEED_NEAR = 256 };                       /* bodies near one that joins the list */
/* Outlets look when a list is made anew, and every so many steps: see demi_step_once. */
enum { DEMI_OUTLET_REST = 64 };

static demi_feed *demi_feed_at(const dem_world *w, int i) { return w->feeds + i; }
static demi_outlet *demi_outlet_at(const dem_world *w, int i) {
    return w->outlets + i;
}
static int demi_box_bad(dem_box b, int planar) {
    return !demi_finite3(b.lo) || !demi_finite3(b.hi) || !(b.hi.x >= b.lo.x) ||
           !(b.hi.y >= b.lo.y) || (!planar && !(b.hi.z >= b.lo.z));
}
DEM_API dem_feed dem_feed_add(dem_world *w, const dem_feed_desc *d) {
    if (demi_null(w, "dem_feed_add", d, "desc")) return demi_no_feed;
    const char *call = "dem_feed_add";
    demi_feed feed;
    dem_feed id;
    int k, m = 0;
    id.id = 0;
    if (demi_material_index(w, call, d->material, &m) != DEM_OK) return id;
    if (d->class_count < 1 || d->class_count > DEM_CLASSES) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "%s: class_count is %d, must be 1 to %d (required)", call,
                  d->class_count, (int)DEM_CLASSES);
        return id;
    }
    memset(&feed, 0, sizeof feed);
    feed.desc = *d;
    for (k = 0; k < d->class_count; k++) {
        if (!(d->radius[k] > 0) || !demi_finite(d->radius[k]) || !(d->amount[k] > 0) ||
            !(d->amount[k] < 1e15) || !demi_finite_double(d->amount[k])) {
            demi_fail(w, DEM_ERROR_ARGUMENT, "%s: class %d has radius %g m and amount %g, must be "
                      "> 0 and finite; leave out classes that do not occur", call, k,
                      (double)d->radius[k], d->amount[k]);
            return id;
        }
        if (demi_mass_refuse(w, call, m, d->radius[k], k)) return id;
        feed.mass[k] = demi_sphere_mass(w, m, (double)d->radius[k]);
        if (d->limited) {
            const double count = d->amount[k]/(d->by_mass ? feed.mass[k] : 1) + 0.5;
            if (!(count >= 1 && count < 1e15)) {
                demi_fail(w, DEM_ERROR_ARGUMENT, "%s: class %d has amount %g, which is %.3g grains "
                          "of radius %g m, must be 1 to 1e15; check amount and by_mass", call, k,
                          d->amount[k], count - 0.5, (double)d->radius[k]);
                return id;
            }
            feed.limit[k] = (uint64_t)count;
        }
    }
    if (!demi_finite_double(d->rate) || !demi_finite_double(d->start) ||
        !demi_finite_double(d->end) || !(d->rate >= 0) || !(d->rate < 1e15) ||
        !(d->start >= 0) || !(d->end >= 0) || !(d->spread >= 0) ||
        !demi_finite(d->spread) || !demi_finite3(d->velocity) ||
        (!(d->rate > 0) && !d->limited) || (d->end > 0 && d->end < d->start)) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "%s: rate is %g, start %g s, end %g s, spread %g m/s; "
                  "must be finite and >= 0, the end 0 or after the start, and all at once (rate 0) "
                  "needs `limited`, or it has no end", call, d->rate, d->start, d->end,
                  (double)d->spread);
        return id;
    }
    if (demi_box_bad(d->box, w->desc.planar)) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "%s: the box is not finite or lo is above hi; give the "
                  "region where centres of new grains are", call);
        return id;
    }
    if (!DEMI_GROW(w, w->feeds, (size_t)w->feed_count + 1)) {
        demi_no_memory(w, call);
        return id;
    }
    feed.random = d->seed;
    feed.next = -1;
    *demi_feed_at(w, w->feed_count++) = feed;
    w->stage.dt_valid = 0;                            /* for grains that are to come */
    demi_built(w, call);
    id.id = w->feed_count;
    return id;
}
static int demi_feed_left(const demi_feed *f) {              /* is there anything more to come? */
    int k, more = !f->desc.limited;
    for (k = 0; k < f->desc.class_count && !more; k++) more = f->limit[k] > f->state.fed[k];
    return more;
}
/* Draws the class of the next grain: by what is left of each, where that is limited, else by the
   share of each in numbers. */
static void demi_feed_draw(demi_feed *f) {
    double weight[DEM_CLASSES], sum = 0, at;
    const int n = f->desc.class_count;
    int k;
    for (k = 0; k < n; k++) {
        weight[k] = f->desc.limited ? (double)(f->limit[k] - f->state.fed[k])
            : f->desc.by_mass ? f->desc.amount[k]/f->mass[k] : f->desc.amount[k];
        sum += weight[k];
    }
    at = sum*demi_uniform(&f->random);
    for (k = 0; k < n - 1 && at >= weight[k]; k++) at -= weight[k];
    while (k > 0 && !(weight[k] > 0)) k--;      /* round-off at the end */
    f->next = k;
}
/* Who feeds: looks at who is near a feed's region, then puts in grains of the class drawn, as long
   as it answers 1; 0: no room; less: minus the result, the sentence is told, nothing happened. */
typedef struct demi_feeder {
    dem_result (*look)(void *who, const demi_region *g, dem_real radius);
    int (*put)(void *who, demi_feed *f, const demi_region *g);
    void *who;
} demi_feeder;
/* Draws a place and a velocity. 0: the place is not of the region. */
static int demi_feed_try(const dem_world *w, demi_feed *f, const demi_region *g, dem_vec3 *x,
                         dem_vec3 *v) {
    const dem_feed_desc *d = &f->desc;
    double u[6];
    int k;
    for (k = 0; k < 6; k++) u[k] = demi_uniform(&f->random);
    *v = demi_v(d->velocity.x + d->spread*(dem_real)(2*u[3] - 1),
                d->velocity.y + d->spread*(dem_real)(2*u[4] - 1),
                d->velocity.z + d->spread*(dem_real)(2*u[5] - 1));
    if (w->desc.planar) v->z = 0;
    return demi_region_at(g, u, d->radius[f->next], x);
}
/* The grain of the class drawn becomes a body; room has been seen to. Answers its index. */
static int demi_feed_append(dem_world *w, const demi_feed *f, dem_vec3 x, dem_vec3 v) {
    const dem_feed_desc *d = &f->desc;
    const uint32_t slot = demi_body_append(w, d->material.id - 1, d->radius[f->next], x);
    const int i = w->bodies.slot_index[slot];
    demi_put(w->bodies.vel + 4*i, v);
    demi_put(w->bodies.half_vel + 4*i, v);
    w->booked.inserted += demi_body_energy(w, i);
    w->booked.speed_max = DEMI_MAX(w->booked.speed_max, (double)demi_length(v));
    return i;
}
/* The grain drawn last is in. */
static void demi_feed_count(demi_feed *f) {
    f->state.fed[f->next]++;
    f->state.total++;
    f->state.mass += f->mass[f->next];
    f->next = -1;
}
/* A world that feeds, and who is near the region. */
typedef struct demi_world_feeder { dem_world *w; demi_crowd crowd; } demi_world_feeder;
static dem_result demi_world_look(void *who, const demi_region *g, dem_real radius) {
    demi_world_feeder *to = (demi_world_feeder *)who;
    return demi_crowd_begin(to->w, &to->crowd, g, radius, demi_periods_of(to->w)) ? DEM_OK
        : demi_no_memory(to->w, "dem_world_step");
}
/* The first of some places that is free. The grain joins the list there is, if it can: then nothing
   of the others' state is made anew. Else the list is, before the step. */
static int demi_world_put(void *who, demi_feed *f, const demi_region *g) {
    dem_world *w = ((demi_world_feeder *)who)->w;
    demi_crowd *c = &((demi_world_feeder *)who)->crowd;
    const dem_feed_desc *d = &f->desc;
    const dem_real r = d->radius[f->next];
    const uint64_t random = f->random;
    dem_vec3 x, v;
    int32_t found[DEMI_FEED_NEAR];
    int tries, i, count = 0, free_place = 0, joins;
    for (tries = 0; tries < DEMI_FEED_TRIES && !free_place; tries++)
        free_place = demi_feed_try(w, f, g, &x, &v) && demi_room_free(w, c, x, r);
    if (!free_place) return 0;
    x = demi_place_of(&c->p, x);
    joins = demi_join_possible(w, d->material.id - 1, r);
    /* one that joins may stand at the half step, too */
    if (!joins || !w->stage.primed) demi_finish(w);
    if (joins)
        count = demi_crowd_look(w, c, x, r + DEM_R(1.001)*(dem_real)w->margin.skin, found,
                                DEMI_FEED_NEAR);
    joins = joins && count <= DEMI_FEED_NEAR;
    if (!demi_crowd_put(w, c, x, r, w->bodies.count) || (!joins && !demi_list_drop(w)) ||
        !demi_bodies_reserve(w, (size_t)w->bodies.count + 1)) {
        f->random = random;
        return -(int)demi_no_memory(w, "dem_world_step");
    }
    i = demi_feed_append(w, f, x, v);
    if (joins) {
        qsort(found, (size_t)count, sizeof *found, demi_int_compare);
        joins = demi_list_join(w, i, found, count);
        w->stage.pairs_changed |= !joins;             /* then the list is made anew */
    }
    if (!joins || w->desc.force || w->desc.body_force) demi_scene_changed(w);
    /* it touches nobody: no force on it is known yet */
    else if (w->stage.primed) demi_prime_body(w, i);
    demi_feed_count(f);
    return 1;
}
/* Where a feed's grains may begin: centres of all sizes alike. */
static int demi_feed_region(const dem_world *w, const dem_feed_desc *d, demi_region *g) {
    dem_region region = demi_region_box(d->box);
    region.cylinder = d->round ? 'z' : 0;
    region.inside = d->inside;
    region.user = d->inside_user;
    return demi_region_make(w, &region, 0, g);
}
/* All that is due now by the clock of w, whose feeds they are. */
static dem_result demi_feeds_run(dem_world *w, const demi_feeder *feeder) {
    dem_result result;
    int i, k;
    for (i = 0; i < w->feed_count; i++) {
        demi_feed *f = demi_feed_at(w, i);
        const dem_feed_desc *d = &f->desc;
        const double until = d->end > 0 && w->clock.time > d->end ? d->end : w->clock.time;
        const double due = d->rate > 0 ? d->rate*(until - d->start) : 1e300;
        int looked = 0;                         /* is the crowd there? */
        demi_region g;
        while (w->clock.time >= d->start && w->clock.steps >= f->again && demi_feed_left(f)) {
            const double rounded = 1e-9*(1 + due);           /* the third of 3/s is due at 1 s */
            int done;
            if (f->next < 0) {
                const uint64_t random = f->random;
                demi_feed_draw(f);
                if (d->by_mass ? f->state.mass + f->mass[f->next] > due + rounded
                    : (double)f->state.total + 1 > due + rounded) {
                    f->random = random;         /* not yet: drawn again when it is */
                    f->next = -1;
                    break;
                }
            }
            if (!looked) {
                dem_real r = 0;
                for (k = 0; k < d->class_count; k++) r = DEMI_MAX(r, d->radius[k]);
                demi_feed_region(w, d, &g);
                result = feeder->look(feeder->who, &g, r + (dem_real)w->margin.skin);
                if (result != DEM_OK) return result;
                looked = 1;
            }
            done = feeder->put(feeder->who, f, &g);
            if (done < 0) return (dem_result)-done;
            if (!done) f->again = w->clock.steps + DEMI_FEED_REST;
        }
        f->state.waiting = 0;
        if (f->next >= 0) {
            double waits = d->by_mass || !(d->rate > 0) ? 1 : due - (double)f->state.total;
            uint64_t most = 0;
            for (k = 0; k < d->class_count; k++) most += f->limit[k] - f->state.fed[k];
            if (!(d->rate > 0) || (d->limited && waits > (double)most)) waits = (double)most;
            waits = DEMI_MIN(DEMI_MAX(waits, 0), 1e18);        /* fits a whole number */
            f->state.waiting = (uint64_t)(waits + 1e-9*waits);
        }
        f->state.done = f->next < 0 &&
            (!demi_feed_left(f) || (d->end > 0 && w->clock.time > d->end));
    }
    return DEM_OK;
}
/* What is due in a world that is not dealt to slabs; before a step. */
static dem_result demi_world_feed(dem_world *w) {
    demi_world_feeder to;
    demi_feeder feeder;
    to.w = w;
    feeder.look = demi_world_look;
    feeder.put = demi_world_put;
    feeder.who = &to;
    return demi_feeds_run(w, &feeder);
}
DEM_API dem_result dem_feed_get(const dem_world *w, dem_feed id, dem_feed_state *state) {
    if (demi_null(w, "dem_feed_get", state, "state")) return DEM_ERROR_ARGUMENT;
    if (id.id < 1 || id.id > w->feed_count)
        return demi_fail((dem_world *)w, DEM_ERROR_ARGUMENT, "dem_feed_get: feed %d does not "
                         "exist, there are %d", (int)id.id, w->feed_count);
    *state = demi_feed_at(w, id.id - 1)->state;
    return DEM_OK;
}

DEM_API dem_outlet dem_outlet_add(dem_world *w, const dem_outlet_desc *d) {
    if (demi_null(w, "dem_outlet_add", d, "desc")) return demi_no_outlet;
    const char *call = "dem_outlet_add";
    demi_outlet outlet;
    dem_outlet id;
    int k, bad = d->class_count < 0 || d->class_count > DEM_CLASSES || !(d->beyond >= 0) ||
        !demi_finite(d->beyond) || !demi_finite(d->wanted_min) || !demi_finite(d->wanted_max) ||
        !(d->wanted_min >= 0) || !(d->wanted_max >= 0) ||
        (d->wanted_max > 0 && !(d->wanted_max > d->wanted_min));
    id.id = 0;
    for (k = 0; k < d->class_count && !bad; k++)
        bad = !(d->radius[k] > (k ? d->radius[k - 1] : 0)) || !demi_finite(d->radius[k]);
    if (bad) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "%s: class_count is %d, beyond %g m, wanted %g to %g m; "
                  "must be 0 to %d classes with ascending radii, lengths >= 0, wanted_min below "
                  "wanted_max", call, d->class_count, (double)d->beyond, (double)d->wanted_min,
                  (double)d->wanted_max, (int)DEM_CLASSES);
        return id;
    }
    if (demi_box_bad(d->box, 0)) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "%s: the box is not finite or lo is above hi; give the "
                  "region that takes grains out", call);
        return id;
    }
    if (d->frame.id && demi_wall_find(w, call, d->frame) < 0) return id;
    if (!DEMI_GROW(w, w->outlets, (size_t)w->outlet_count + 1)) {
        demi_no_memory(w, call);
        return id;
    }
    memset(&outlet, 0, sizeof outlet);
    outlet.desc = *d;
    outlet.state.since = w->clock.time;
    *demi_outlet_at(w, w->outlet_count++) = outlet;
    demi_built(w, call);
    id.id = w->outlet_count;
    return id;
}
/* Counts grain i: in the class whose radius is nearest, and as wanted or not. */
static void demi_outlet_book(dem_world *w, demi_outlet *o, int i) {
    const dem_outlet_desc *d = &o->desc;
    const dem_real r = w->bodies.pos[4*i + 3];
    const double m = (double)w->bodies.mass[i];
    const int wanted = r >= d->wanted_min && (!(d->wanted_max > 0) || r <= d->wanted_max);
    int k = 0;
    while (k + 1 < d->class_count && 2*r > d->radius[k] + d->radius[k + 1]) k++;
    o->state.count[k]++;
    o->state.mass[k] += m;
    o->state.total++;
    o->state.total_mass += m;
    *(wanted ? &o->state.sorted : &o->state.gangue) += 1;
    *(wanted ? &o->state.sorted_mass : &o->state.gangue_mass) += m;
    o->state.last = w->clock.time;
}
static int demi_outlet_has(const dem_outlet_desc *d, dem_vec3 x) {
    return x.x >= d->box.lo.x && x.x <= d->box.hi.x && x.y >= d->box.lo.y && x.y <= d->box.hi.y &&
           x.z >= d->box.lo.z && x.z <= d->box.hi.z &&
           x.x*x.x + x.y*x.y >= d->beyond*d->beyond;
}
/* A place in the frame of an outlet's region; in a periodic world the image nearest to the region's
   centre, or, of a region without end, the one in the box. */
static dem_vec3 demi_outlet_place(const dem_world *w, const demi_periods *p,
                                  const dem_outlet_desc *d, dem_vec3 x) {
    const dem_pose *pose = d->frame.id ? &w->walls[d->frame.id - 1].pose : 0;
    dem_vec3 c = demi_scale(demi_add(d->box.lo, d->box.hi), DEM_R(0.5));
    if (p->any) {
        dem_real at[3], mid[3];
        int k;
        if (pose) c = demi_add(pose->position, demi_rotate(pose->rotation, c));
        demi_put(at, x);
        demi_put(mid, c);
        for (k = 0; k < 3; k++)
            at[k] = demi_into(at[k], DEMI_ABS(mid[k] - p->lo[k]) < 1000*p->period[k]
                              ? mid[k] - p->half[k] : p->lo[k], p->period[k]);
        x = demi_at(at);
    }
    return pose ? demi_unrotate(pose->rotation, demi_sub(x, pose->position)) : x;
}
/* After a move: the first outlet that a grain is in takes it. */
static dem_result demi_outlets_run(dem_world *w) {
    const demi_periods p = demi_periods_of(w);
    int i, k;
    for (i = 0; i < w->bodies.count && w->outlet_count; i++)
        for (k = 0; k < w->outlet_count && !demi_is_ghost(w, i); k++) {
            demi_outlet *o = demi_outlet_at(w, k);
            const int frame = o->desc.frame.id;
            if (frame && w->walls[frame - 1].kind == DEMI_WALL_NONE) continue;
            if (!demi_outlet_has(&o->desc, demi_outlet_place(w, &p, &o->desc,
                                                             demi_at(w->bodies.pos +
                                                                     4*i)))) continue;
            if (!demi_list_drop(w)) return demi_no_memory(w, "dem_world_step");
            demi_outlet_book(w, o, i);
            demi_body_take_out(w, i--);
            w->bodies.balance.left++;
            break;
        }
    return DEM_OK;
}
static demi_outlet *demi_outlet_find(const dem_world *w, const char *call, dem_outlet id) {
    if (id.id >= 1 && id.id <= w->outlet_count) return demi_outlet_at(w, id.id - 1);
    demi_fail((dem_world *)w, DEM_ERROR_ARGUMENT, "%s: outlet %d does not exist, there are %d",
              call, (int)id.id, w->outlet_count);
    return 0;
}
DEM_API dem_result dem_outlet_get(const dem_world *w, dem_outlet id, dem_outlet_state *state) {
    if (demi_null(w, "dem_outlet_get", state, "state")) return DEM_ERROR_ARGUMENT;
    const demi_outlet *o = demi_outlet_find(w, "dem_outlet_get", id);
    if (!o) return DEM_ERROR_ARGUMENT;
    *state = o->state;
    return DEM_OK;
}
DEM_API dem_result dem_outlet_reset(dem_world *w, dem_outlet id) {
    if (demi_null(w, "dem_outlet_reset", w, "world")) return DEM_ERROR_ARGUMENT;
    demi_outlet *o = demi_outlet_find(w, "dem_outlet_reset", id);
    if (!o) return DEM_ERROR_ARGUMENT;
    memset(&o->state, 0, sizeof o->state);
    o->state.since = w->clock.time;
    return DEM_OK;
}

/* ---------------------------------------------------------------------------------------------
   >>advice
   Which time step a scene bears: contact times and stable steps of the pairs that may meet, of the
   contacts that are there, of spins and speeds; what dt = 0 chooses and what is refused by name.
   Reads everything, writes only dt and room of its own.
   --------------------------------------------------------------------------------------------- */

/* m/s, how fast a wall's surface will move, whether it has begun to or not; of a motion that is the
   user's own, how fast it does now. */
static double demi_motion_speed(const demi_wall *wall) {
    const dem_motion *m = &wall->motion;
    const double far = (double)DEMI_MAX(wall->extent, wall->radius);
    dem_vec3 spin;
    switch (m->kind) {
    case DEM_MOTION_FIXED: return 0;
    case DEM_MOTION_TRANSLATING: return (double)demi_length(m->velocity);
    case DEM_MOTION_ROTATING:
        spin = demi_scale(demi_unit(m->axis), m->speed);
        return (double)demi_length(demi_cross(spin, demi_sub(wall->pose.position, m->point))) +
               (double)demi_length(spin)*far;
    case DEM_MOTION_OSCILLATING: return 2*DEMI_PI*fabs((double)m->frequency*(double)m->amplitude);
    default: break;
    }
    return (double)demi_length(wall->pose.velocity) + (double)demi_length(wall->pose.spin)*far;
}
/* Impact speed to reckon with: given, or the largest of what grains do now, what walls will do and
   what gravity can make of the height there is. */
static double demi_speed_estimate(const dem_world *w) {
    double g = (double)demi_length(w->desc.gravity), speed = 0, lo = 1e300, hi = -1e300;
    dem_vec3 down = g > 0 ? demi_unit(w->desc.gravity) : demi_v(0, 0, 0);
    int i, k;
    if (w->desc.impact_speed > 0) return (double)w->desc.impact_speed;
    for (i = 0; i < w->bodies.count; i++) {
        const dem_vec3 v = demi_at(w->bodies.vel + 4*i);
        const double h = (double)demi_dot(demi_at(w->bodies.pos + 4*i), down);
        const double r = (double)w->bodies.pos[4*i + 3];
        speed = DEMI_MAX(speed, (double)demi_length(v));
        lo = DEMI_MIN(lo, h - r);
        hi = DEMI_MAX(hi, h + r);
    }
    for (i = 0; i < w->feed_count; i++) {       /* grains that are to come */
        const dem_feed_desc *d = &demi_feed_at(w, i)->desc;
        for (k = 0; k < 2; k++) {
            const double h = (double)demi_dot(k ? d->box.hi : d->box.lo, down);
            lo = DEMI_MIN(lo, h);
            hi = DEMI_MAX(hi, h);
        }
        speed = DEMI_MAX(speed, (double)demi_length(d->velocity) + 1.7320508*(double)d->spread);
    }
    for (i = 0; i < w->wall_count; i++) {
        const demi_wall *wall = &w->walls[i];
        if (wall->kind == DEMI_WALL_NONE) continue;
        speed = DEMI_MAX(speed, demi_motion_speed(wall));
        if (demi_wall_is(wall, DEMI_FLAT) || (wall->vertex_count &&
                                              !demi_wall_is(wall, DEMI_DRAWN))) {
            const int n = DEMI_MAX(wall->vertex_count, 1);
            for (k = 0; k < n; k++) {
                const dem_vec3 p = !wall->vertex_count ? wall->pose.position :
                    demi_add(wall->pose.position, demi_rotate(wall->pose.rotation,
                                                            demi_at(wall->vertices + 3*k)));
                hi = DEMI_MAX(hi, (double)demi_dot(p, down));
            }
        } else hi = DEMI_MAX(hi, (double)demi_dot(wall->pose.position, down) +
                             (double)DEMI_MAX(wall->radius, wall->extent));
    }
    if (g > 0 && hi > lo) speed = DEMI_MAX(speed, sqrt(2*g*(hi - lo)));
    return DEMI_MAX(speed, 1e-3);
}

/* The radius of the sphere that stands for a body when contact times are looked for. Not a sphere:
   one as light as a contact may find the body at worst; for Hertz, whose time goes with
   (m^2/R)^(1/5), lighter still by the root of how much blunter the body is somewhere. */
static double demi_advise_radius(const dem_world *w, int body) {
    const demi_shape *shape = demi_shape_of(w, body);
    double r = (double)w->bodies.pos[4*body + 3], scale, sharp;
    if (!shape) return r;
    scale = r/(double)shape->radius;
    r = (double)shape->equal*scale*pow(shape->light, 1.0/3);
    sharp = r/((double)shape->blunt*scale);
    return demi_normal_is(w, DEMI_HERTZIAN) && sharp < 1 ? r*pow(sharp, 1.0/6) : r;
}
/* The largest step at which x'' = -omega2 x - rate x' keeps still by velocity Verlet with predicted
   velocities: omega2 dt^2/4 + rate dt = 1, s. (For the other integrators about the same.) */
static double demi_dt_stable(double omega2, double rate) {
    return 2/(rate + sqrt(rate*rate + omega2) + 1e-300);
}
/* How stiff and how damped one contact is at an overlap, for small motions: N/m and N s/m, rolling
   N m and N m s. */
typedef struct demi_stiffness { double k, kt, kr, c, ct, cr; } demi_stiffness;
/* Slopes of force against way, and of damping against speed, at an overlap: what the stability of a
   step hangs on. Of a law of the user's own, what desc.law_stiffness says. */
static demi_stiffness demi_stiffness_of(const dem_world *w, const dem_real *coef, double m_eff,
                                        double overlap) {
    const double root = sqrt(overlap), r = (double)coef[DEMI_R_EFF];
    const double arm = (double)coef[DEMI_MU_ROLL]*r;
    demi_stiffness s;
    s.k = (double)coef[DEMI_KN];
    s.kt = (double)coef[DEMI_KT]; s.c = (double)coef[DEMI_CN]; s.ct = (double)coef[DEMI_CT];
    if (demi_normal_is(w, DEMI_HERTZIAN)) {
        s.k *= 1.5*root; s.kt *= root;
        s.c *= sqrt(root); s.ct *= sqrt(root);
    }
    s.kr = s.cr = 0;
    if (demi_rolling_laws[demi_rolling_meant(w)].traits & DEMI_SPRUNG) {
        s.kr = 2.25*s.k*arm*arm;
        s.cr = 0.6*sqrt(s.kr*1.4*m_eff*r*r);
    }
    if (demi_normal_is(w, DEMI_BRANCHED)) s.k = (double)coef[DEMI_K_UN];
    if (w->desc.tangent_law == DEM_TANGENT_NONE || !(coef[DEMI_MU_STATIC] > 0)) s.kt = s.ct = 0;
    if (w->desc.law) {
        memset(&s, 0, sizeof s);
        s.k = (double)w->desc.law_stiffness;
    }
    return s;
}
/* Of one contact to come, of spheres that meet at a speed: at its deepest. */
static double demi_dt_of_contact(const dem_world *w, const dem_real *coef, double m_eff,
                                 double speed) {
    const double deep = pow(5*m_eff*speed*speed/(4*(double)coef[DEMI_KN]), 0.4);
    const demi_stiffness s = demi_stiffness_of(w, coef, m_eff, deep);
    const double I = 0.4*m_eff*(double)coef[DEMI_R_EFF]*(double)coef[DEMI_R_EFF];
    const double slide = 3.5*s.kt/m_eff + s.kr/I;
    return demi_dt_stable(DEMI_MAX(s.k/m_eff, slide), DEMI_MAX(s.c/m_eff, 3.5*s.ct/m_eff + s.cr/I));
}
/* What each material's grains are: those there are, and those that feeds will bring. */
typedef struct demi_grades {
    double smallest[DEMI_MATERIALS], peg[DEMI_MATERIALS];  /* m: moving; largest that is fixed */
    int many[DEMI_MATERIALS];                              /* that move, or more of their like */
} demi_grades;
/* Feeds count as if two grains of each class were there already. */
static void demi_grades_of(const dem_world *w, demi_grades *g) {
    int i, j;
    memset(g, 0, sizeof *g);
    for (i = 0; i < w->bodies.count; i++) {
        const int m = w->bodies.material[i] - 1;
        const double r = demi_advise_radius(w, i);
        if (w->bodies.inv_mass[i] <= 0) { g->peg[m] = DEMI_MAX(g->peg[m], r); continue; }
        if (!g->many[m]++ || r < g->smallest[m]) g->smallest[m] = r;
    }
    for (i = 0; i < w->feed_count; i++) {
        const dem_feed_desc *d = &demi_feed_at(w, i)->desc;
        const int m = d->material.id - 1;
        for (j = 0; j < d->class_count; j++) {
            const double r = (double)d->radius[j];
            if (!g->many[m] || r < g->smallest[m]) g->smallest[m] = r;
            g->many[m] += 2;
        }
    }
}
/* The contact that lasts shortest, of those looked at so far, and the least stable step. */
typedef struct demi_shortest {
    double time, limit, radius, partner;       /* s, s, m, m */
    int material, other, wall;                 /* indices; wall: 1 + index, 0: none */
} demi_shortest;
/* Smallest grains of material i with one kind of partner: material `other` (fixed or not), wall. */
static void demi_advise_pair(const dem_world *w, const demi_grades *g, int i, int other, int fixed,
                             int wall, double speed, demi_shortest *s) {
    const double r = g->smallest[i], m = demi_sphere_mass(w, i, r);
    double m_eff = m, r_eff = r, partner = 0, t;
    dem_real coef[DEMI_COEFS];
    if (wall < 0) {
        partner = fixed ? g->peg[other] : g->smallest[other];
        if (!(partner > 0)) return;
        if (!fixed) m_eff = 1/(1/m + 1/demi_sphere_mass(w, other, partner));
        r_eff = r*partner/(r + partner);
    }
    demi_coefficients(w, i, other, r_eff, m_eff, m_eff, wall >= 0, coef);
    if (w->desc.law && w->desc.law_stiffness > 0)
        t = DEMI_PI*sqrt(m_eff/(double)w->desc.law_stiffness);
    else {
        t = demi_contact_time(w, coef, m_eff, speed);
        s->limit = DEMI_MIN(s->limit, demi_dt_of_contact(w, coef, m_eff, speed));
    }
    if (t >= s->time) return;
    s->time = t;
    s->radius = r;
    s->partner = partner;
    s->material = i;
    s->other = other;
    s->wall = wall + 1;
}
/* pi r sqrt(rho/G)/(.1631 nu + .8766), the time a surface wave takes over the smallest grain. */
static double demi_rayleigh(const dem_material_desc *d, double r) {
    const double nu = (double)d->poisson, G = (double)d->young/(2*(1 + nu));
    return G > 0 ? DEMI_PI*r*sqrt((double)d->density/G)/(0.1631*nu + 0.8766) : 1e300;
}
/* Shortest contact among all material pairs and walls there are, for their smallest grains. */
static void demi_advise(const dem_world *w, dem_advice *out) {
    const double speed = demi_speed_estimate(w);
    double rayleigh = 1e300;
    demi_shortest s = {1e300, 1e300, 0, 0, -1, -1, 0};
    demi_grades g;
    int i, j;
    demi_grades_of(w, &g);
    for (i = 0; i < w->material_count; i++) {
        if (!(g.smallest[i] > 0)) continue;
        rayleigh = DEMI_MIN(rayleigh, demi_rayleigh(&w->materials[i], g.smallest[i]));
        for (j = 0; j < w->material_count; j++)
            if (j != i || g.many[i] > 1) demi_advise_pair(w, &g, i, j, 0, -1, speed, &s);
        for (j = 0; j < w->material_count; j++) demi_advise_pair(w, &g, i, j, 1, -1, speed, &s);
        for (j = 0; j < w->wall_count; j++)
            if (w->walls[j].kind != DEMI_WALL_NONE)
                demi_advise_pair(w, &g, i, w->walls[j].material, 0, j, speed, &s);
    }
    for (i = 0; i < w->material_count && s.material < 0; i++)     /* one grain alone: its like */
        if (g.smallest[i] > 0) {
            const double limit = s.limit;
            demi_advise_pair(w, &g, i, i, 0, -1, speed, &s);
            s.limit = limit;                    /* which is not there to be unstable with */
        }
    memset(out, 0, sizeof *out);
    out->speed = (dem_real)speed;
    out->rayleigh = (dem_real)(rayleigh < 1e300 ? rayleigh : 0);
    if (s.material < 0) {
        snprintf(out->binds, sizeof out->binds, "no grain that moves");
        s.time = 0;
    } else if (s.wall)
        snprintf(out->binds, sizeof out->binds, "grains of material %d, radius %g m, on wall %d of "
                 "material %d, at %.3g m/s", s.material + 1, s.radius, s.wall, s.other + 1, speed);
    else
        snprintf(out->binds, sizeof out->binds, "grains of materials %d and %d, radii %g and %g m, "
                 "at %.3g m/s", s.material + 1, s.other + 1, s.radius, s.partner, speed);
    out->contact_time = (dem_real)s.time;
    out->dt = (dem_real)DEMI_MIN(s.time/50, s.limit/5);
    out->dt_max = (dem_real)DEMI_MIN(s.time/20, s.limit);
    if (s.time > 0 && s.limit < s.time/20) {
        const size_t n = strlen(out->binds);
        snprintf(out->binds + n, sizeof out->binds - n, "; stable to %.3g s, by its dashpot, "
                 "friction or rolling", s.limit);
    }
}

/* --- contacts that are there: pressed, and many to a grain. The largest step that is stable, from
       below: the matrix of all contacts' stiffness is no more than the sum over bodies of twice
       their own contacts' (once, where the partner does not move), so
           omega2 <= max over bodies of (a + b)/2 + sqrt((a - b)^2/4 + q^2)
           A = sum f [k n n + kt (1 - n n)]/m,  B = sum f [kt l^2 (1 - n n) + kr]/I,
           q = |sum f kt l n|/sqrt(m I),       a, b: norms of A, B (largest sum along a row)
       and the same for damping. Exact for close packings that shear and spin. A cheap bound per
       body comes first (max over directions per contact, summed); few bodies need the matrices, and
       only when the step is within a factor of two or so of its limit. Spheres only. Checked by "a
       time step that is accepted is stable where twelve contacts a grain are pressed". --- */
typedef struct demi_press {
    double omega2, rate;           /* 1/s2, 1/s: the cheap bound */
    int32_t contacts, whole;       /* how many; 1 + index of its matrices, 0: none needed */
    dem_real deepest;              /* of its radius */
} demi_press;
typedef struct demi_press_whole {  /* per mass, inertia, root of both */
    double A[2][6], B[2][6], q[2][3];          /* 0: stiffness, 1: damping */
} demi_press_whole;
typedef struct demi_pressed { demi_stiffness s; dem_vec3 n; dem_real overlap; } demi_pressed;
/* The cheap bound: stiffnesses of all contacts of a body added as if they were along one line. */
static void demi_press_add(const dem_world *w, int body, const demi_pressed *c, int moving,
                           double arm, demi_press *p) {
    const double m = (double)w->bodies.mass[body], f = moving ? 2 : 1;
    const double I = demi_sphere_inertia(w, m, (double)w->bodies.pos[4*body + 3]);
    if (w->bodies.inv_mass[body] <= 0) return;
    p->omega2 += f*DEMI_MAX(c->s.k/m, c->s.kt*(1/m + arm*arm/I) + c->s.kr/I);
    p->rate += f*DEMI_MAX(c->s.c/m, c->s.ct*(1/m + arm*arm/I) + c->s.cr/I);
    p->contacts++;
    p->deepest = DEMI_MAX(p->deepest, c->overlap/w->bodies.pos[4*body + 3]);
}
/* The close one, where the cheap bound is not enough: the matrices of stiffness and damping of the
   body, for its way (A), its turning (B), and how one asks for the other (q). */
static void demi_press_add_whole(const dem_world *w, int body, const demi_pressed *c, int moving,
                                 double arm, demi_press_whole *p) {
    const double m = (double)w->bodies.mass[body], f = moving ? 2 : 1;
    const double I = demi_sphere_inertia(w, m, (double)w->bodies.pos[4*body + 3]);
    const double n[3] = {(double)c->n.x, (double)c->n.y, (double)c->n.z};
    int i, j, e = 0, d;
    if (w->bodies.inv_mass[body] <= 0) return;
    for (i = 0; i < 3; i++)
        for (j = i; j < 3; j++, e++)
            for (d = 0; d < 2; d++) {
                const double one = i == j ? 1 : 0, nn = n[i]*n[j];
                const double k = d ? c->s.c : c->s.k, kt = d ? c->s.ct : c->s.kt;
                p->A[d][e] += f*(k*nn + kt*(one - nn))/m;
                p->B[d][e] += f*(kt*arm*arm*(one - nn) + (d ? c->s.cr : c->s.kr)*one)/I;
            }
    for (d = 0; d < 2; d++)
        for (i = 0; i < 3; i++) p->q[d][i] += f*(d ? c->s.ct : c->s.kt)*arm*n[i]/sqrt(m*I);
}
/* The largest sum of a row, of a symmetric matrix of six numbers: no eigenvalue is larger. */
static double demi_press_norm(const double *A) {
    const double x = fabs(A[0]) + fabs(A[1]) + fabs(A[2]), y = fabs(A[1]) + fabs(A[3]) + fabs(A[4]);
    return DEMI_MAX(DEMI_MAX(x, y), fabs(A[2]) + fabs(A[4]) + fabs(A[5]));
}
/* The bound of either matrix, d 0 stiffness, 1 damping. */
static double demi_press_bound(const demi_press_whole *p, int d) {
    const double a = demi_press_norm(p->A[d]), b = demi_press_norm(p->B[d]);
    const double q2 = p->q[d][0]*p->q[d][0] + p->q[d][1]*p->q[d][1] + p->q[d][2]*p->q[d][2];
    return (a + b)/2 + sqrt((a - b)*(a - b)/4 + q2);
}
/* All contacts of spheres with each other and with walls. */
static void demi_press_visit(const dem_world *w, demi_press *press, demi_press_whole *whole) {
    int d, p, side;
    for (d = 0; d < w->domain_count; d++) {
        const demi_domain *domain = &w->domains[d];
        for (p = demi_near_first(domain); p < domain->near_end; p = demi_near_next(domain, p)) {
            const demi_span span = demi_span_of(w, d, p, 1);
            const int a = span.a[0], b = span.b[0];
            const dem_real *x = w->bodies.pos + 4*a, *y = w->bodies.pos + 4*b;
            const dem_vec3 gap = demi_add(demi_sub(demi_at(y), demi_at(x)),
                                          demi_at(w->image_shift + span.image[0]));
            const dem_real l = demi_length(gap), sum = x[3] + y[3];
            const int both = w->bodies.inv_mass[a] > 0 && w->bodies.inv_mass[b] > 0;
            dem_real coef[DEMI_PAIR_COLUMNS];
            demi_pressed c;
            if (!(l < sum) || !(l > 0)) continue;
            if (whole && !press[a].whole && !press[b].whole) continue;
            demi_span_coefs(w, &span, 0, coef);
            c.s = demi_stiffness_of(w, coef, (double)coef[DEMI_M_EFF], (double)(sum - l));
            c.n = demi_scale(gap, 1/l);
            c.overlap = sum - l;
            for (side = 0; side < 2; side++) {
                const int i = side ? b : a;
                const double arm = (double)(l*(side ? y[3] : x[3])/sum);
                if (!whole) demi_press_add(w, i, &c, both, arm, press + i);
                else if (press[i].whole)
                    demi_press_add_whole(w, i, &c, both, arm, whole + press[i].whole - 1);
            }
        }
        for (p = 0; p < domain->kept; p++) {
            const demi_kept *k = demi_kept_of(w, d) + p;
            const int i = k->a;
            const double arm = (double)w->bodies.pos[4*i + 3];
            dem_real coef[DEMI_COEFS];
            demi_pressed c;
            if (!(k->overlap > 0) || k->b >= 0 || demi_shape_of(w, i) ||
                (whole && !press[i].whole)) continue;
            demi_kept_coefs(w, k, coef);
            c.s = demi_stiffness_of(w, coef, (double)w->bodies.mass[i], (double)k->overlap);
            c.n = k->normal;
            c.overlap = k->overlap;
            if (!whole) demi_press_add(w, i, &c, 0, arm, press + i);
            else demi_press_add_whole(w, i, &c, 0, arm, whole + press[i].whole - 1);
        }
    }
}
/* The largest stable step for the contacts there are, if it is below dt; else 0; -1: memory ran
   out. worst: the body. Its room is kept. */
static double demi_press_limit(dem_world *w, double dt, int *worst) {
    demi_press *press;
    demi_press_whole *whole;
    double least = dt;
    int i, found = 0;
    if (!w->bodies.count) return 0;
    if (!DEMI_GROW(w, w->press, (size_t)w->bodies.count)) return -1;
    press = w->press;
    memset(press, 0, (size_t)w->bodies.count*sizeof *press);
    demi_press_visit(w, press, 0);
    for (i = 0; i < w->bodies.count; i++)
        if (dt > demi_dt_stable(press[i].omega2, press[i].rate)) press[i].whole = ++found;
    if (!found) return 0;
    if (!DEMI_GROW(w, w->press_whole, (size_t)found)) return -1;
    whole = w->press_whole;
    memset(whole, 0, (size_t)found*sizeof *whole);
    demi_press_visit(w, press, whole);
    for (i = 0; i < w->bodies.count; i++) {
        const demi_press_whole *p = whole + press[i].whole - 1;
        double limit;
        if (!press[i].whole) continue;
        limit = demi_dt_stable(demi_press_bound(p, 0), demi_press_bound(p, 1));
        if (limit < least) { least = limit; *worst = i; }
    }
    return least < dt ? least : 0;
}

/* Says that a body that is not a sphere turns too far in a step. */
static dem_result demi_spins_refuse(dem_world *w, double rate, const char *call) {
    return demi_fail(w, DEM_ERROR_TIME_STEP, "%s: step %llu: a body that is not a sphere turns by "
                     "%.3g rad in a step of %g s, must be at most 1; its spin is %.3g rad/s: use "
                     "dt = 0 or at most %.2g s, or look for what spun it up", call,
                     (unsigned long long)w->clock.steps, rate*(double)w->clock.dt,
                     (double)w->clock.dt, rate, 0.1/rate);
}
/* The fastest spin among those bodies, rad/s. */
static double demi_spin_fastest(const dem_world *w) {
    double most = w->clock.spin_elsewhere;
    int i;
    for (i = 0; i < w->bodies.count && w->bodies.shaped; i++)
        if (w->bodies.shape[i])
            most = DEMI_MAX(most, (double)demi_length(demi_at(w->bodies.spin + 4*i)));
    return most;
}
/* Settles dt before stepping: chosen or checked. */
DEM_API dem_result dem_step_advice(const dem_world *w, dem_advice *advice) {
    if (demi_null(w, "dem_step_advice", advice, "advice")) return DEM_ERROR_ARGUMENT;
    demi_advise(w, advice);
    if (advice->contact_time > 0) return DEM_OK;
    return demi_fail((dem_world *)w, DEM_ERROR_ARGUMENT, "dem_step_advice: the world has no grain "
                     "that moves; add grains before asking for a time step");
}
/* The time step for the scene as it is, asked for or advised; one that is not stable is refused.
   A change of the step ends half steps of the old one first. */
static dem_result demi_dt_settle(dem_world *w) {
    dem_advice a;
    double spin;
    if (w->stage.dt_valid) return DEM_OK;
    if (!w->bodies.count && !w->feed_count) {          /* nothing to limit it: walls still move */
        if (!(w->clock.dt > 0)) w->clock.dt = w->desc.dt > 0 ? w->desc.dt : DEM_R(1e-3);
        return DEM_OK;
    }
    demi_finish(w);                             /* speeds are those of now, whoever asks */
    demi_advise(w, &a);
    spin = demi_spin_fastest(w);
    if (w->desc.dt > 0) {
        if (!w->desc.allow_large_dt && a.contact_time > 0 && w->desc.dt > a.dt_max)
            return demi_fail(w, DEM_ERROR_TIME_STEP, "dem_world_step: dt is %g s, must be at most "
                             "t_c/20 = %g s (t_c of %s"
                             "); use dt = 0, a softer material or a smaller dt",
                             (double)w->desc.dt, (double)a.dt_max, a.binds);
        w->clock.dt = w->desc.dt;
        if (!w->desc.allow_large_dt && spin*(double)w->clock.dt > 1)
            return demi_spins_refuse(w, spin, "dem_world_step");
    } else {
        const dem_real easy = a.contact_time > 0 ? a.dt : DEM_R(1e-3);
        const dem_real share = w->dt_share > 0 ? (dem_real)w->dt_share : 1;
        const dem_real dt = share*(spin*(double)easy > 0.1 ? (dem_real)(0.1/spin) : easy);
        /* half steps were of the old dt */
        if (dt < w->clock.dt || dt > w->clock.dt) { demi_finish(w); w->stage.primed = 0; }
        w->clock.dt = dt;
    }
    w->clock.assumed_speed = (double)a.speed;
    w->stage.dt_valid = 1;
    w->clock.press_due = w->clock.press_since = w->clock.steps;
    return DEM_OK;
}
/* The fastest body that moves, m/s. */
static double demi_fastest(const dem_world *w) {
    double most = 0;
    int i;
    for (i = 0; i < w->bodies.count; i++)
        if (w->bodies.inv_mass[i] > 0)
            most = DEMI_MAX(most, (double)demi_dot(demi_at(w->bodies.vel + 4*i),
                                                   demi_at(w->bodies.vel + 4*i)));
    return sqrt(most);
}
/* m/s, how fast a body may be in the next step by the forces that act now. */
static double demi_fastest_next(const dem_world *w) {
    double most = 0;
    int i, k;
    for (i = 0; i < w->bodies.count; i++) {
        const double inv = (double)w->bodies.inv_mass[i];
        const double g[3] = {(double)w->desc.gravity.x, (double)w->desc.gravity.y,
                             (double)w->desc.gravity.z};
        double a2 = 0;
        for (k = 0; k < 3; k++) a2 += pow((double)w->bodies.force[4*i + k]*inv + g[k], 2);
        if (inv > 0)
            most = DEMI_MAX(most, (double)demi_length(demi_at(w->bodies.vel + 4*i)) +
                            sqrt(a2)*(double)w->clock.dt);
    }
    return most;
}
/* Refuses a step in which the fastest moves farther than the smallest radius: it would pass others
   and walls unseen. speed: a bound, m/s; named: 1 where w has bodies to look for it. */
static dem_result demi_speed_check(dem_world *w, double speed, int named) {
    const double radius = (double)w->effects.radius_min, dt = (double)w->clock.dt;
    double most = 0;
    char who[80] = "a body";
    int i;
    if (!(speed*dt > radius && radius > 0)) return DEM_OK;
    for (i = 0; i < w->bodies.count && named; i++) {
        const double v = (double)demi_length(demi_at(w->bodies.vel + 4*i));
        if (v <= most) continue;
        most = v;
        snprintf(who, sizeof who, "body %u, the fastest, is at %.3g m/s and",
                 (unsigned)w->bodies.slot[i] + 1, v);
    }
    return demi_fail(w, DEM_ERROR_TIME_STEP, "dem_world_step: step %llu: %s may reach %.3g m/s in "
                     "this step: it moves %.3g radii of the smallest grain (%g m) in a step of %g "
                     "s, must be at most 1: it would pass others and walls unseen; use at most "
                     "%.2g s, or look for what made it so fast",
                     (unsigned long long)w->clock.steps, who, speed, speed*dt/radius, radius, dt,
                     0.1*radius/speed);
}
/* The same of walls that are thin: planes and cylinders cannot be passed. */
static dem_result demi_wall_speed_check(dem_world *w, double radius, double dt) {
    int i;
    for (i = 0; i < w->wall_count; i++) {
        const demi_wall *wall = &w->walls[i];
        const int kind = wall->kind;
        double speed;
        if (kind == DEMI_WALL_NONE || kind == DEMI_WALL_PLANE || kind == DEMI_WALL_CYLINDER ||
            wall->motion.kind == DEM_MOTION_FIXED || !(radius > 0)) continue;
        speed = demi_wall_speed(wall);
        if (!(speed*dt > radius)) continue;
        return demi_fail(w, DEM_ERROR_TIME_STEP, "dem_world_step: step %llu: wall %d moves at up "
                         "to %.3g m/s, %.3g radii of the smallest grain (%g m) in a step of %g s, "
                         "must be at most 1: it would pass grains unseen; use at most %.2g s, or a "
                         "slower wall", (unsigned long long)w->clock.steps, i + 1, speed,
                         speed*dt/radius, radius, dt, 0.1*radius/speed);
    }
    return DEM_OK;
}
/* What presses has been looked at: again more and more rarely while the scene stays, at least every
   thousand steps. */
static void demi_press_looked(demi_timing *clock) {
    clock->press_due = clock->steps + DEMI_MIN(8*(clock->steps - clock->press_since) + 8, 1000);
}
/* Refuses a step that was given, for this body is pressed so that `limit` is the largest. */
static dem_result demi_press_refuse(dem_world *w, double limit, int worst) {
    return demi_fail(w, DEM_ERROR_TIME_STEP, "dem_world_step: step %llu: dt is %g s, must be at "
                     "most %g s: body %u is pressed by %d contacts, by %.3g of its radius at most; "
                     "use dt = 0, a smaller dt, or less overlap",
                     (unsigned long long)w->clock.steps, (double)w->clock.dt, limit,
                     (unsigned)w->bodies.slot[worst] + 1, (int)w->press[worst].contacts,
                     (double)w->press[worst].deepest);
}
/* Asks, with lists and contacts at hand, whether the step suits what presses now and how fast
   bodies move. A step that was chosen is made smaller; one that was given is refused, before
   anything moves. */
static dem_result demi_dt_check(dem_world *w) {
    const int chosen = !(w->desc.dt > 0);
    const double share = w->dt_share > 0 ? w->dt_share : 1;
    dem_result result;
    double limit;
    int worst = 0;
    if (w->desc.allow_large_dt || !w->bodies.count) return DEM_OK;
    /* after a change of the scene the last kick may be that of a body which is gone */
    result = demi_speed_check(w, w->clock.steps == w->clock.press_since
                              ? DEMI_MIN(demi_fastest(w) + w->margin.last_change,
                                         demi_fastest_next(w))
                              : w->margin.last_change + w->booked.speed_max, 1);
    if (result == DEM_OK)
        result = demi_wall_speed_check(w, (double)w->effects.radius_min, (double)w->clock.dt);
    if (result != DEM_OK || w->clock.steps < w->clock.press_due) return result;
    limit = demi_press_limit(w, (double)w->clock.dt*(chosen ? 2/share : 1), &worst);
    if (limit < 0) return demi_no_memory(w, "dem_world_step");
    demi_press_looked(&w->clock);
    if (!(limit > 0)) return DEM_OK;
    if (!chosen) return demi_press_refuse(w, limit, worst);
    demi_finish(w);
    w->stage.primed = 0;
    w->clock.dt = (dem_real)(limit*DEMI_MIN(share/2, 0.95));
    return DEM_OK;
}

/* ---------------------------------------------------------------------------------------------
   >>check
   What is likely to be wrong with a scene, before it runs. Each function looks for mistakes of one
   kind and puts a sentence in for each. Limits are such that scenes of practice pass: grains from
   0.1 um to 0.5 m, matter from foam to osmium, moduli softened to 1e4 Pa.
   --------------------------------------------------------------------------------------------- */

/* The most severe of all findings; what is found first comes first among its like. */
typedef struct demi_findings { dem_finding *to; int room, kept, count; } demi_findings;
static void demi_find(demi_findings *f, dem_severity severity, const char *format, ...)
    DEMI_FORMAT(3, 4);
static void demi_find(demi_findings *f, dem_severity severity, const char *format, ...) {
    int i = f->kept;
    va_list arguments;
    f->count++;
    while (i > 0 && f->to[i - 1].severity < severity) i--;
    if (i >= f->room) return;
    if (f->kept < f->room) f->kept++;
    memmove(f->to + i + 1, f->to + i, (size_t)(f->kept - 1 - i)*sizeof *f->to);
    f->to[i].severity = severity;
    va_start(arguments, format);
    vsnprintf(f->to[i].text, sizeof f->to[i].text, format, arguments);
    va_end(arguments);
}

/* Units and sizes of matter. */
static void demi_check_materials(const dem_world *w, demi_findings *f) {
    int used[DEMI_MATERIALS], i;
    memset(used, 0, sizeof used);
    for (i = 0; i < w->bodies.count; i++) used[w->bodies.material[i] - 1] = 1;
    for (i = 0; i < w->wall_count; i++)
        if (w->walls[i].kind != DEMI_WALL_NONE) used[w->walls[i].material] = 1;
    for (i = 0; i < w->feed_count; i++) used[demi_feed_at(w, i)->desc.material.id - 1] = 1;
    for (i = 0; i < w->material_count; i++) {
        const dem_material_desc *m = &w->materials[i];
        if (!used[i])
            demi_find(f, DEM_SEVERITY_NOTE, "material %d is used by no grain, wall or feed", i + 1);
        if (m->density < 10 || m->density > 25000)
            demi_find(f, DEM_SEVERITY_WARNING, "material %d has a density of %g kg/m3: densities "
                      "are in kg/m3 (water 1000), was %g g/cm3 meant?", i + 1, (double)m->density,
                      (double)(m->density < 10 ? m->density : m->density/1000));
        if (!w->desc.law && !(m->stiffness > 0) &&
            (m->young < DEM_R(1e4) || m->young > DEM_R(2e12)))
            demi_find(f, DEM_SEVERITY_WARNING, "material %d has a Young's modulus of %g Pa: moduli "
                      "are in Pa (glass 7e10, softened 1e6 to 1e8)", i + 1, (double)m->young);
        if (m->friction > 2)
            demi_find(f, DEM_SEVERITY_WARNING, "material %d has a friction of %g: it is a "
                      "coefficient, not an angle; tan of %g degrees is %.3g", i + 1,
                      (double)m->friction, (double)m->friction,
                      tan((double)m->friction*DEMI_PI/180));
        if (m->rolling_friction > 1)
            demi_find(f, DEM_SEVERITY_WARNING,
                      "material %d has a rolling friction of %g: it counts "
                      "in effective radii, 0.01 to 0.3 as a rule", i + 1,
                      (double)m->rolling_friction);
        if (m->rolling_friction > 0 && !(m->friction > 0))
            demi_find(f, DEM_SEVERITY_NOTE, "material %d has rolling friction and no sliding "
                      "friction: its grains slide instead of rolling", i + 1);
    }
    if (w->desc.threads > demi_threads_available() && demi_threads_available() > 0)
        demi_find(f, DEM_SEVERITY_NOTE, "threads is %d, but only %d can run at once: more are "
                  "slower", w->desc.threads, demi_threads_available());
}
static void demi_radii_of(const dem_world *w, double *least, double *most) {
    int i;
    *least = 1e300;
    *most = 0;
    for (i = 0; i < w->bodies.count; i++) {
        *least = DEMI_MIN(*least, (double)w->bodies.pos[4*i + 3]);
        *most = DEMI_MAX(*most, (double)w->bodies.pos[4*i + 3]);
    }
}
static void demi_check_radii(const dem_world *w, demi_findings *f) {
    double least, most;
    demi_radii_of(w, &least, &most);
    if (most > 0.5)
        demi_find(f, DEM_SEVERITY_WARNING, "the largest grain has a radius of %g m: lengths are in "
                  "metres, was %g mm meant?", most, most);
    if (least < 1e-7)
        demi_find(f, DEM_SEVERITY_WARNING, "the smallest grain has a radius of %g m: below 1e-7 m "
                  "attraction and thermal motion outweigh what is simulated here", least);
}

/* m, how far along n (unit) from the origin a wall may stop what comes that way; 1e300: without
   end, -1e300: nowhere (a plane seen along itself or from behind, a tube through its opening). */
static double demi_wall_far(const demi_wall *wall, dem_vec3 n) {
    const dem_vec3 own = demi_unrotate(wall->pose.rotation, n);
    const int drawn = demi_wall_is(wall, DEMI_DRAWN);
    double far = -1e300;
    int i;
    if (demi_wall_is(wall, DEMI_FLAT)) return own.z < DEM_R(-1e-3) ? 1e300 : -1e300;
    if (DEMI_ABS(own.z) > DEM_R(0.999) && (drawn || (wall->extent < 0 && wall->radius > 0)))
        return -1e300;
    if (wall->extent < 0 || (drawn && DEMI_ABS(own.z) > DEM_R(1e-6))) return 1e300;
    for (i = 0; i < wall->vertex_count; i++)
        far = DEMI_MAX(far, (double)demi_dot(demi_at(wall->vertices + 3*i), own));
    if (!wall->vertex_count) far = (double)DEMI_MAX(wall->extent, wall->radius);
    else if (demi_wall_is(wall, DEMI_BALLS)) far += (double)wall->radius;
    return far + (double)demi_dot(wall->pose.position, n);
}
/* m, the longest side of its box, or its diameter. */
static double demi_wall_size(const demi_wall *wall) {
    const dem_vec3 box = demi_sub(wall->box.hi, wall->box.lo);
    if (!wall->vertex_count) return 2*(double)wall->extent;
    return (double)DEMI_MAX(box.x, DEMI_MAX(box.y, demi_wall_is(wall, DEMI_DRAWN) ? 0 : box.z));
}
/* Does anything move, and does anything stop it? */
static void demi_check_motion(const dem_world *w, demi_findings *f) {
    const dem_vec3 g = w->desc.gravity;
    const int pulled = demi_dot(g, g) > 0, forced = w->desc.force || w->desc.body_force;
    dem_vec3 down = pulled ? demi_unit(g) : demi_v(0, 0, 0);
    double lowest = -1e300, floor = -1e300, speed = 0;
    int i, moving = 0;
    for (i = 0; i < w->bodies.count; i++) {
        const double h = (double)demi_dot(demi_at(w->bodies.pos + 4*i), down);
        if (w->bodies.inv_mass[i] <= 0) { floor = DEMI_MAX(floor, h); continue; }
        moving++;
        lowest = DEMI_MAX(lowest, h);
        speed = DEMI_MAX(speed, (double)demi_length(demi_at(w->bodies.vel + 4*i)));
    }
    if (!moving && !w->feed_count) {
        demi_find(f, DEM_SEVERITY_ERROR, "no grain moves, and no feed brings any: add grains, with "
                  "dem_spheres_fill for one");
        return;
    }
    if (!pulled && !forced && !(speed > 0) && moving)
        demi_find(f, DEM_SEVERITY_WARNING, "all grains rest, and there is neither gravity nor a "
                  "force: set gravity (0, 0, -9.81 m/s2) or velocities");
    for (i = 0; i < w->wall_count; i++)
        if (w->walls[i].kind != DEMI_WALL_NONE)
            floor = DEMI_MAX(floor, demi_wall_far(&w->walls[i], down));
    if (pulled && moving && !forced && floor < lowest && !(DEMI_ABS(down.x) > DEM_R(0.1) &&
        w->desc.boundary[0] == DEM_BOUNDARY_PERIODIC) && !(DEMI_ABS(down.y) > DEM_R(0.1) &&
        w->desc.boundary[1] == DEM_BOUNDARY_PERIODIC) && !(DEMI_ABS(down.z) > DEM_R(0.1) &&
        w->desc.boundary[2] == DEM_BOUNDARY_PERIODIC))
        demi_find(f, DEM_SEVERITY_WARNING, "gravity is (%g, %g, %g) m/s2, and no wall or fixed "
                  "grain is below the lowest grain: they fall for ever; add a floor, or turn "
                  "gravity", (double)g.x, (double)g.y, (double)g.z);
}

/* Is a wall with ends all behind some plane, or beyond a face where grains leave? */
static int demi_wall_hidden(const dem_world *w, const demi_wall *wall) {
    double lo[3], hi[3];
    int k;
    if (demi_wall_is(wall, DEMI_DRAWN)) return 0;       /* it goes on and on */
    demi_domain_limits(w, lo, hi);
    for (k = 0; k < w->wall_count; k++) {
        const demi_wall *plane = &w->walls[k];
        const dem_vec3 n = demi_rotate(plane->pose.rotation, demi_v(0, 0, 1));
        if (plane->kind == DEMI_WALL_NONE || !demi_wall_is(plane, DEMI_FLAT)) continue;
        if (demi_wall_far(wall, n) < (double)demi_dot(plane->pose.position, n)) return 1;
    }
    for (k = 0; k < 3; k++) {
        const dem_vec3 n = demi_v(k == 0, k == 1, k == 2);
        if (w->desc.boundary[k] == DEM_BOUNDARY_OUTFLOW &&
            (demi_wall_far(wall, n) < lo[k] || -demi_wall_far(wall, demi_scale(n, -1)) > hi[k]))
            return 1;
    }
    return 0;
}
/* Sizes and places of walls, beside those of grains. */
static void demi_check_walls(const dem_world *w, demi_findings *f) {
    double least, most;
    int i;
    demi_radii_of(w, &least, &most);
    for (i = 0; i < w->wall_count; i++) {
        const demi_wall *wall = &w->walls[i];
        const double size = demi_wall_size(wall);
        if (wall->kind == DEMI_WALL_NONE || wall->extent < 0) continue;
        if (most > 0 && size > 2e4*most)
            demi_find(f, DEM_SEVERITY_WARNING, "wall %d, a %s, is %g m long, %.3g radii of the "
                      "largest grain: was it in millimetres? scale it by 0.001", i + 1,
                      demi_wall_kinds[wall->kind].name, size, size/most);
        else if (most > 0 && size < least)
            demi_find(f, DEM_SEVERITY_WARNING, "wall %d, a %s, is %g m long, less than the radius "
                      "of the smallest grain, %g m: is it in other units?", i + 1,
                      demi_wall_kinds[wall->kind].name, size, least);
        if (demi_wall_hidden(w, wall))
            demi_find(f, DEM_SEVERITY_WARNING, "wall %d, a %s, is behind a plane or outside the "
                      "domain: nothing can reach it; does the plane's normal point to the grains?",
                      i + 1, demi_wall_kinds[wall->kind].name);
    }
}

/* Grains inside each other, in walls, or out of the domain. Needs lists. */
static void demi_check_pairs(const dem_world *w, demi_findings *f) {
    double worst = 0.01;
    int d, k, cross, count = 0, who[2] = {0, 0};
    for (d = 0; d < w->domain_count; d++)
        for (cross = 0; cross < 2; cross++) {
            const demi_list *list = cross ? &w->cross : &w->own;
            const int from = d*list->stride, n = cross ? w->domains[d].cross : w->domains[d].own;
            for (k = from; k < from + n; k++) {
                const int a = list->a[k], b = list->b[k];
                const dem_real r = DEMI_MIN(w->bodies.pos[4*a + 3], w->bodies.pos[4*b + 3]);
                const double deep = -(double)(demi_bodies_gap(w, a, b, w->image_shift +
                                                              list->image[k], r)/r);
                if (!(deep > 0.01) || (w->bodies.inv_mass[a] <= 0 && w->bodies.inv_mass[b] <= 0))
                    continue;
                count++;
                if (deep <= worst) continue;
                worst = deep;
                who[0] = (int)w->bodies.slot[a] + 1;
                who[1] = (int)w->bodies.slot[b] + 1;
            }
        }
    if (count)
        demi_find(f, worst >= 1 ? DEM_SEVERITY_ERROR : worst > 0.05 ? DEM_SEVERITY_WARNING
                  : DEM_SEVERITY_NOTE,
                      "%d pair%s of grains begin%s inside each other, bodies %d and "
                  "%d by %.3g of the smaller radius: they will fly apart; place them by "
                  "dem_spheres_fill, or farther from each other", count, count > 1 ? "s" : "",
                  count > 1 ? "" : "s", who[0], who[1], worst);
}
static void demi_check_in_walls(dem_world *w, demi_findings *f) {
    double worst = 0.01;
    int d, k, count = 0, body = 0, wall = 0;
    if (!demi_touch(w)) return;                 /* no memory: the run will say so */
    for (d = 0; d < w->domain_count; d++)
        for (k = 0; k < w->domains[d].kept_next; k++) {
            const demi_kept *c = w->kept_next + w->kept_first[d] + k;
            if (c->b >= 0 || !((double)c->deep > 0.01)) continue;
            count++;
            if ((double)c->deep <= worst) continue;
            worst = (double)c->deep;
            body = (int)w->bodies.slot[c->a] + 1;
            wall = c->wall + 1;
        }
    for (d = 0; d < w->domain_count; d++) w->domains[d].kept_next = w->domains[d].kept;
    if (count)
        demi_find(f, worst >= 1 ? DEM_SEVERITY_ERROR : worst > 0.05 ? DEM_SEVERITY_WARNING
                  : DEM_SEVERITY_NOTE, "grains begin in walls at %d place%s, body %d in wall %d by "
                  "%.3g of its radius: move it, or does the wall's normal (inside) point the wrong "
                  "way?", count, count > 1 ? "s" : "", body, wall, worst);
}
static void demi_check_outside(const dem_world *w, demi_findings *f) {
    double lo[3], hi[3];
    int i, k, count = 0;
    demi_domain_limits(w, lo, hi);
    for (i = 0; i < w->bodies.count; i++)
        for (k = 0; k < 3; k++) {
            const double x = (double)w->bodies.pos[4*i + k];
            if (w->desc.boundary[k] != DEM_BOUNDARY_OUTFLOW || (x >= lo[k] && x <= hi[k])) continue;
            count++;
            break;
        }
    if (count)
        demi_find(f, DEM_SEVERITY_WARNING, "%d grain%s outside the domain, whose faces take out "
                  "what crosses them: gone with the first step; make the domain larger", count,
                  count > 1 ? "s are" : " is");
}

/* The time step that was asked for, beside what the scene bears. */
static void demi_check_step(dem_world *w, const dem_advice *a, demi_findings *f) {
    const double dt = (double)w->desc.dt;
    double limit, fastest = demi_fastest(w);
    int i, worst = 0;
    if (!(dt > 0) || !(a->contact_time > 0)) return;
    for (i = 0; i < w->wall_count; i++)
        if (w->walls[i].kind != DEMI_WALL_NONE)
            fastest = DEMI_MAX(fastest, demi_motion_speed(&w->walls[i]));
    if (dt > (double)a->dt_max)
        demi_find(f, w->desc.allow_large_dt ? DEM_SEVERITY_WARNING : DEM_SEVERITY_ERROR, "dt is %g "
                  "s, more than %g s, which %s bear: use dt = 0, or softer material", dt,
                  (double)a->dt_max, a->binds);
    else if ((limit = demi_press_limit(w, dt, &worst)) > 0)
        demi_find(f, DEM_SEVERITY_ERROR,
                  "dt is %g s, more than %g s, which body %d bears, pressed by "
                  "%d contacts: use dt = 0", dt, limit, (int)w->bodies.slot[worst] + 1,
                  (int)w->press[worst].contacts);
    else if (dt < (double)a->dt/20)
        demi_find(f, DEM_SEVERITY_NOTE, "dt is %g s, %.3g times smaller than need be (t_c/50 = %g "
                  "s): the run takes that much longer; use dt = 0", dt, (double)a->dt/dt,
                  (double)a->dt);
    if (w->effects.radius_min > 0 && fastest*dt > (double)w->effects.radius_min)
        demi_find(f, DEM_SEVERITY_ERROR, "at %.3g m/s a grain or wall moves %.3g radii of the "
                  "smallest grain in a step of %g s: they would pass each other unseen; use dt = 0",
                  fastest, fastest*dt/(double)w->effects.radius_min, dt);
}
/* Overlaps, over the radius, of the smallest grains of each material with their like: when they
   meet at the speed there may be, and under the weight of all, were they stacked where they are. */
static void demi_check_overlaps(const dem_world *w, const dem_advice *a, demi_findings *f) {
    const double g = (double)demi_length(w->desc.gravity), v = (double)a->speed;
    const int hertz = demi_normal_is(w, DEMI_HERTZIAN);
    double lo[3] = {1e300, 1e300, 1e300}, hi[3] = {-1e300, -1e300, -1e300}, area = 0, mass = 0;
    const double n[3] = {(double)w->desc.gravity.x, (double)w->desc.gravity.y,
                         (double)w->desc.gravity.z};
    demi_grades grades;
    int i, k;
    if (w->desc.law) return;                    /* nothing is known of it */
    for (i = 0; i < w->bodies.count; i++) {
        if (w->bodies.inv_mass[i] > 0) mass += (double)w->bodies.mass[i];
        for (k = 0; k < 3; k++) {
            const double x = (double)w->bodies.pos[4*i + k], r = (double)w->bodies.pos[4*i + 3];
            lo[k] = DEMI_MIN(lo[k], x - r);
            hi[k] = DEMI_MAX(hi[k], x + r);
        }
    }
    for (k = 0; k < 3 && g > 0 && mass > 0; k++)
        area += fabs(n[k])/g*(hi[(k + 1)%3] - lo[(k + 1)%3])*(hi[(k + 2)%3] - lo[(k + 2)%3]);
    demi_grades_of(w, &grades);
    for (i = 0; i < w->material_count; i++) {
        const double r = grades.smallest[i], m = r > 0 ? demi_sphere_mass(w, i, r)/2 : 0;
        double deep[2] = {0, 0}, force, kn;
        dem_real coef[DEMI_COEFS];
        if (!(r > 0)) continue;
        demi_coefficients(w, i, i, r/2, m, m, 0, coef);
        kn = (double)coef[DEMI_KN];
        force = area > 0 && !w->desc.planar ? 4*r*r*mass*g/area : 0;
        deep[0] = hertz ? pow(5*m*v*v/(4*kn), 0.4)/r : v*sqrt(m/kn)/r;
        deep[1] = (hertz ? pow(force/kn, 2.0/3) : force/kn)/r;
        for (k = 0; k < 2; k++) {
            const double more = pow(deep[k]/0.01, k ? (hertz ? 1.5 : 1) : hertz ? 2.5 : 2);
            if (!(deep[k] > 0.05)) continue;
            demi_find(f, deep[k] > 0.3 ? DEM_SEVERITY_WARNING : DEM_SEVERITY_NOTE, "grains of "
                      "material %d (radius %g m) will overlap by %.2g of their radius %s%.3g %s: "
                      "below 0.01 with %s of %.2g %s", i + 1, r, deep[k], k ? "under a weight of "
                      : "at ", k ? force : v, k ? "N each" : "m/s", w->materials[i].stiffness > 0
                      ? "a stiffness" : "a Young's modulus", more*(double)
                      (w->materials[i].stiffness > 0 ? w->materials[i].stiffness
                                                     : w->materials[i].young),
                      w->materials[i].stiffness > 0 ? "N/m" : "Pa");
        }
    }
}

DEM_API int dem_world_check(dem_world *w, dem_finding *findings, int capacity) {
    demi_findings f;
    dem_advice advice;
    if (demi_null(w, "dem_world_check", w, "world")) return 0;
    memset(&f, 0, sizeof f);
    f.to = findings;
    f.room = findings && capacity > 0 ? capacity : 0;
    demi_advise(w, &advice);
    demi_check_motion(w, &f);
    demi_check_radii(w, &f);
    demi_check_materials(w, &f);
    demi_check_walls(w, &f);
    demi_check_outside(w, &f);
    demi_check_overlaps(w, &advice, &f);
    if (!w->bodies.count) return f.count;
    if (!w->stage.list_valid && demi_rebuild(w, "dem_world_check") != DEM_OK) {
        demi_find(&f, DEM_SEVERITY_ERROR, "%.230s", w->error);
        return f.count;
    }
    demi_check_pairs(w, &f);
    demi_check_in_walls(w, &f);
    demi_check_step(w, &advice, &f);
    return f.count;
}

DEM_API int dem_check_print(dem_world *w, FILE *out) {
    static const char *const severities[] = {"note", "note", "warning", "error"};
    dem_finding findings[16];
    int i, n = dem_world_check(w, findings, 16);
    for (i = 0; out && i < n && i < 16; i++)
        fprintf(out, "%s: %s\n", severities[findings[i].severity], findings[i].text);
    return n;
}

/* ---------------------------------------------------------------------------------------------
   >>step
   One step in the order of the manual, and runs of many. The parts of a step run over domains,
   in parallel, and wait for each other where one needs what another domain has done: after the
   move (who has come near?), after touch (had all contacts room?), after respond (forces that
   are fetched). A step begins where the one before ended its forces; its last half kick is left
   open until somebody looks (demi_finish), since the next step's first one is the same sum:
   velocities are touched once a step, not twice. What only a look needs, kinetic energy among
   it, is worked out at the look. Errors of a run are found in the step that caused them and name
   the body; a step that ran out of memory after its move is marked (stage.moved) and goes on
   from there.
   --------------------------------------------------------------------------------------------- */

/* How fast the fastest is, how much the most accelerated, and a sum that keeps what is not finite
   (a maximum loses it). In groups, each place of which has its own maximum and sum: that is what
   makes vectors of it. */
typedef struct demi_pace {
    dem_real speed2[DEMI_LANES], acceleration2[DEMI_LANES], sum[DEMI_LANES];
} demi_pace;
/* Maxima and a sum, per lane: the sum is not finite when any velocity is not. */
DEM_INLINE void demi_pace_look(const dem_world *w, int i, demi_pace *DEMI_RESTRICT pace, int l) {
    const dem_real *v = w->bodies.half_vel + 4*i, *f = w->bodies.force + 4*i,
        inv = w->bodies.inv_mass[i];
    const dem_vec3 g = w->desc.gravity;
    const dem_real s = v[0]*v[0] + v[1]*v[1] + v[2]*v[2];
    const dem_real x = f[0]*inv + g.x, y = f[1]*inv + g.y, z = f[2]*inv + g.z;
    const dem_real a = x*x + y*y + z*z;
    pace->speed2[l] = s > pace->speed2[l] ? s : pace->speed2[l];
    pace->acceleration2[l] = a > pace->acceleration2[l] ? a : pace->acceleration2[l];
    pace->sum[l] += s;
}
/* Moves some bodies, looks at their pace, clears their forces. */
static void demi_some_move(dem_world *w, demi_domain *domain, int begin, int end, int turning,
                           demi_pace *pace) {
    const size_t bytes = (size_t)(end - begin)*4*sizeof(dem_real);
    int i, l;
    demi_integrator_rows[w->desc.integrator].move(w, begin, end, turning);
    if (w->desc.planar)
        for (i = begin; i < end; i++) {
            w->bodies.pos[4*i + 2] = w->bodies.vel[4*i + 2] = 0;
            w->bodies.spin[4*i] = w->bodies.spin[4*i + 1] = 0;
            w->bodies.half_vel[4*i + 2] = w->bodies.half_spin[4*i] = w->bodies.half_spin[4*i + 1] =
                0;
        }
    if (w->bodies.orienting) demi_orient_move(w, domain, begin, end);
    for (i = begin; i + DEMI_LANES <= end; i += DEMI_LANES) {
        DEMI_VECTOR
        for (l = 0; l < DEMI_LANES; l++) demi_pace_look(w, i + l, pace, l);
    }
    for (; i < end; i++) demi_pace_look(w, i, pace, 0);
    memset(w->bodies.force + 4*begin, 0, bytes);
    if (turning) memset(w->bodies.torque + 4*begin, 0, bytes);
}
/* The same for a domain in which some bodies may be quiet. */
static void demi_quiet_move(dem_world *w, int d, int turning, demi_pace *pace) {
    demi_domain *domain = &w->domains[d];
    const dem_real *DEMI_RESTRICT u = w->bodies.half_vel, dt = w->clock.dt;
    dem_real *DEMI_RESTRICT x = w->bodies.pos;
    int i, k, end, l;
    for (i = domain->begin; i < domain->end; i = end) {
        demi_quiet *q = demi_quiet_at(w, d, i);
        end = DEMI_MIN((i/DEMI_SOME + 1)*DEMI_SOME, domain->end);
        if (q->restless) {
            demi_pace own;
            memset(&own, 0, sizeof own);
            demi_some_move(w, domain, i, end, turning, &own);
            q->speed2 = 0;
            for (l = 0; l < DEMI_LANES; l++) {
                q->speed2 = DEMI_MAX(q->speed2, own.speed2[l]);
                pace->acceleration2[l] = DEMI_MAX(pace->acceleration2[l], own.acceleration2[l]);
                pace->sum[l] += own.sum[l];
            }
            if (q->restless == 1) q->restless = 0;
        } else {
            for (k = 4*i; k < 4*end; k++) x[k] += u[k]*dt;
            if (w->bodies.orienting) demi_orient_move(w, domain, i, end);
        }
        pace->speed2[0] = DEMI_MAX(pace->speed2[0], q->speed2);
    }
}
/* All bodies of a domain, a few at a time; what is found on the way goes into the domain's sums. */
static void demi_domain_move(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    const int turning = demi_turns(w), some = 64;   /* these stay in the nearest cache */
    demi_pace pace;
    int i;
    memset(&pace, 0, sizeof pace);
    domain->energy[DEMI_E_GRAVITY] = 0;
    domain->speed2 = domain->acceleration2 = domain->check = 0;
    domain->turn = domain->turn_speed = domain->turn_rate = 0;
    if (demi_quiet_possible(w)) demi_quiet_move(w, d, turning, &pace);
    else for (i = domain->begin; i < domain->end; i += some)
        demi_some_move(w, domain, i, DEMI_MIN(i + some, domain->end), turning, &pace);
    for (i = 0; i < DEMI_LANES; i++) {
        domain->speed2 = DEMI_MAX(domain->speed2, (double)pace.speed2[i]);
        domain->acceleration2 = DEMI_MAX(domain->acceleration2, (double)pace.acceleration2[i]);
        domain->check += (double)pace.sum[i];
    }
    if (w->desc.ledger) {
        const dem_vec3 g = w->desc.gravity;
        for (i = domain->begin; i < domain->end; i++) {
            const dem_real *u = w->bodies.half_vel + 4*i;
            if (w->bodies.inv_mass[i] <= 0) continue;
            domain->energy[DEMI_E_GRAVITY] += (double)w->bodies.mass[i]*(double)(g.x*u[0] +
                                                                                 g.y*u[1] +
                g.z*u[2])*(double)w->clock.dt;
        }
    }
}

/* Forces and torques of a field that sees whole bodies. */
static void demi_domain_fields(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    int i;
    for (i = domain->begin; i < domain->end; i++) {
        const dem_body id = dem_bodies_id(w, i);
        const dem_vec3 none = demi_v(0, 0, 0);
        dem_vec3 force = none, torque = none;
        dem_body_state body;
        if (demi_is_ghost(w, i) || dem_body_get(w, id, &body) != DEM_OK) continue;
        w->desc.body_force(&body, id, w->clock.time, &force, &torque, w->desc.force_user);
        demi_force_add(w->bodies.force + 4*i, force);
        demi_force_add(w->bodies.torque + 4*i, torque);
        if (w->desc.ledger && w->stage.forces_valid && w->bodies.inv_mass[i] > 0)
            domain->energy[DEMI_E_FORCE] += (double)(demi_dot(force, body.velocity) +
                                                     demi_dot(torque,
                                                              body.spin))*(double)w->clock.dt;
    }
}
/* Force field, or nothing, to start the sums with; after a move forces are clear already. */
static void demi_domain_clear(dem_world *w, int d) {
    const demi_domain *domain = &w->domains[d];
    const size_t n = (size_t)(domain->end - domain->begin)*4*sizeof(dem_real);
    int i;
    if (n && !w->stage.moved) {
        memset(w->bodies.force + 4*domain->begin, 0, n);
        memset(w->bodies.torque + 4*domain->begin, 0, n);
    }
    for (i = domain->begin; i < domain->end && w->desc.force; i++) {
        if (demi_is_ghost(w, i)) continue;
        const dem_vec3 f = w->desc.force(demi_at(w->bodies.pos + 4*i), demi_at(w->bodies.vel + 4*i),
                                         w->bodies.pos[4*i + 3], w->bodies.mass[i],
                                         w->clock.time, w->desc.force_user);
        demi_put(w->bodies.force + 4*i, f);
        if (w->desc.ledger && w->stage.forces_valid && w->bodies.inv_mass[i] > 0)
            w->domains[d].energy[DEMI_E_FORCE] += (double)demi_dot(f,
                demi_at(w->bodies.vel + 4*i))*(double)w->clock.dt;
    }
    if (w->desc.body_force) demi_domain_fields(w, d);
}
/* All contacts that a domain owns. Its own bodies are summed here; forces on bodies of other
   domains stay in slots until all have answered (demi_cross_gather). */
static void demi_domain_respond(dem_world *w, int d) {
    const size_t walls = (size_t)w->wall_count;
    demi_domain_clear(w, d);
    if (walls) memset(w->wall_sums + (size_t)d*walls, 0, walls*sizeof *w->wall_sums);
    w->kernel(w, d);
    demi_kept_clear(w, d);
    demi_kept_respond(w, d);
}
/* What others did to this domain's bodies, in the order of their entries. */
static void demi_domain_gather(dem_world *w, int d) {
    int i;
    if (w->cross_entries) demi_cross_gather(w, d);
    if (demi_own(w)) {                          /* those of your own may answer anything */
        double sum = 0;
        for (i = 4*w->domains[d].begin; i < 4*w->domains[d].end; i++)
            sum += fabs((double)w->bodies.force[i]) + fabs((double)w->bodies.torque[i]);
        w->domains[d].check = sum;
    }
    if (!w->desc.planar) return;
    /* nothing pushes a disc out of its plane */
    for (i = w->domains[d].begin; i < w->domains[d].end; i++)
        w->bodies.force[4*i + 2] = w->bodies.torque[4*i] = w->bodies.torque[4*i + 1] = 0;
}
/* Forces at the present positions and velocities; wall loads. */
static void demi_forces(dem_world *w) {
    const double dt = w->stage.forces_valid ? (double)w->clock.dt : 0;
    demi_kept *kept = w->kept_now;
    int d, i, k;
    for (d = 0; d < w->domain_count; d++) {
        w->domains[d].overlap = 0;
        for (i = 0; i < DEMI_ENERGIES; i++) w->domains[d].energy[i] = 0;
    }
    demi_parallel(w, w->desc.threads, w->domain_count, demi_domain_respond);
    demi_parallel(w, w->desc.threads, w->domain_count, demi_domain_gather);
    w->kept_now = w->kept_next;
    w->kept_next = kept;
    for (d = 0; d < w->domain_count; d++) w->domains[d].kept = w->domains[d].kept_next;
    for (i = 0; i < w->wall_count; i++) {  /* domains in order: one order whatever the threads */
        dem_wall_loads *c = &w->walls[i].loads;
        const dem_vec3 axis = w->walls[i].motion.axis;
        double f[3] = {0, 0, 0}, t[3] = {0, 0, 0}, power = 0;
        if (w->walls[i].kind == DEMI_WALL_NONE) continue;
        c->contacts = 0;
        for (d = 0; d < w->domain_count; d++) {
            const demi_wall_sum *s = &w->wall_sums[d*w->wall_count + i];
            for (k = 0; k < 3; k++) { f[k] += s->force[k]; t[k] += s->torque[k]; }
            power += s->power;
            c->contacts += s->contacts;
        }
        c->force = demi_v((dem_real)f[0], (dem_real)f[1], (dem_real)f[2]);
        c->torque = demi_v((dem_real)t[0], (dem_real)t[1], (dem_real)t[2]);
        c->torque_axial = demi_dot(c->torque, demi_unit(axis));
        c->power = (dem_real)power;
        for (k = 0; k < 3; k++) c->impulse[k] += f[k]*dt;
        c->torque_impulse += (double)c->torque_axial*dt;
        c->work += power*dt;
        c->time += dt;
    }
    for (d = 0; d < w->domain_count; d++)
        w->booked.overlap_max = DEMI_MAX(w->booked.overlap_max, w->domains[d].overlap);
    if (w->desc.ledger) demi_ledger_book(w);
}

/* Which two bodies overlap most, of the smaller radius. Answers by how much. */
static double demi_deepest_pair(const dem_world *w, int *first, int *second) {
    double most = 0;
    int d, k;
    for (d = 0; d < w->domain_count; d++) {
        const demi_domain *domain = &w->domains[d];
        const demi_kept *kept = demi_kept_of(w, d);
        for (k = 0; k < domain->near_end; k++) {
            const int at = d*w->near.stride + k, a = w->near.a[at], b = w->near.b[at];
            const dem_real *p = w->bodies.pos + 4*a, *q = w->bodies.pos + 4*b;
            const dem_vec3 r = demi_add(demi_sub(demi_at(q), demi_at(p)),
                                        demi_at(w->image_shift + w->near.image[at]));
            const double deep = (double)((p[3] + q[3] - demi_length(r))/DEMI_MIN(p[3], q[3]));
            if (k >= domain->near_own && k < domain->near_cross) continue;
            if (deep > most) { most = deep; *first = a; *second = b; }
        }
        for (k = 0; k < domain->kept; k++)
            if (kept[k].b >= 0 && (double)kept[k].deep > most) {
                most = (double)kept[k].deep;
                *first = kept[k].a;
                *second = kept[k].b;
            }
    }
    return most;
}

/* Names the body that went wrong. */
static dem_result demi_unstable(dem_world *w) {
    int i, d, first = 0, second = 0;
    double deepest;
    for (i = 0; i < w->bodies.count; i++)
        if (!demi_finite3(demi_at(w->bodies.pos + 4*i)) ||
            !demi_finite3(demi_at(w->bodies.vel + 4*i)) ||
            !demi_finite3(demi_at(w->bodies.spin + 4*i)) ||
                !demi_finite3(demi_at(w->bodies.force + 4*i)) ||
            !demi_finite3(demi_at(w->bodies.torque + 4*i)))
            return demi_fail(w, DEM_ERROR_UNSTABLE, "dem_world_step: step %llu, body %u: its "
                             "position, velocity or spin is no "
                             "longer a finite number; likely two grains stand at the same place, a "
                             "law, force field or motion of your own divided by zero, or dt "
                             "= %g s is too large", (unsigned long long)w->clock.steps,
                             (unsigned)w->bodies.slot[i] + 1, (double)w->clock.dt);
    for (d = 0; d < w->domain_count; d++)
        for (i = 0; i < w->domains[d].kept; i++) {
            const demi_kept *c = demi_kept_of(w, d) + i;
            if (c->b < 0 && c->deep >= 1)
                return demi_fail(w, DEM_ERROR_UNSTABLE, "dem_world_step: step %llu, body %u "
                                 "overlaps wall %d by %.3g of its "
                                 "radius, must be below 1; it started inside the wall, hit it too "
                                 "fast for dt = %g s, or the "
                                 "material is too soft", (unsigned long long)w->clock.steps,
                                 (unsigned)w->bodies.slot[c->a] + 1, (int)c->wall + 1,
                                 (double)c->deep, (double)w->clock.dt);
        }
    deepest = demi_deepest_pair(w, &first, &second);
    if (!(deepest >= 1)) {
        double most = 0;
        for (i = 0; i < w->bodies.count; i++)
            for (d = 0; d < 3; d++) {
                const double v = fabs((double)w->bodies.vel[4*i + d]);
                const double f = fabs((double)w->bodies.force[4*i + d]);
                const double size = DEMI_MAX(v, f*(double)w->bodies.inv_mass[i]);
                if (size > most) { most = size; first = i; }
            }
        return demi_fail(w, DEM_ERROR_UNSTABLE, "dem_world_step: step %llu, body %u: its force, "
                         "speed or place is beyond what can be calculated with; a law, force "
                         "field or motion of your own answered a huge number, or dt = %g s is too "
                         "large", (unsigned long long)w->clock.steps,
                         (unsigned)w->bodies.slot[first] + 1, (double)w->clock.dt);
    }
    return demi_fail(w, DEM_ERROR_UNSTABLE, "dem_world_step: step %llu: bodies %u and %u overlap "
                     "by %.3g of the smaller radius, must be below 1; they started inside each "
                     "other, met too fast for dt = %g s, or the material is too soft",
                     (unsigned long long)w->clock.steps, (unsigned)w->bodies.slot[first] + 1,
                     (unsigned)w->bodies.slot[second] + 1, deepest, (double)w->clock.dt);
}

/* Bodies whose centre left through an outflow boundary are taken out. */
static dem_result demi_outflow(dem_world *w) {
    double lo[3], hi[3];
    int i, k, any = 0;
    demi_domain_limits(w, lo, hi);
    for (k = 0; k < 3; k++) any |= w->desc.boundary[k] == DEM_BOUNDARY_OUTFLOW;
    if (!any) return DEM_OK;
    for (i = 0; i < w->bodies.count; i++)
        for (k = 0; k < 3; k++) {
            const double x = (double)w->bodies.pos[4*i + k];
            if (w->desc.boundary[k] != DEM_BOUNDARY_OUTFLOW || (x >= lo[k] && x <= hi[k])) continue;
            if (!demi_list_drop(w)) return demi_no_memory(w, "dem_world_step");
            demi_body_take_out(w, i--);
            w->bodies.balance.left++;
            break;
        }
    return DEM_OK;
}

/* What is asked for now goes into the fields of >>measure. */
static size_t demi_field_cells(const demi_field *f) {
    return (size_t)f->desc.cells[0]*(size_t)f->desc.cells[1]*(size_t)f->desc.cells[2];
}
/* What one body at x adds to a field, if it is there. */
static void demi_field_add(const dem_world *w, demi_field *field, int i, const double *x) {
    const dem_field_desc *d = &field->desc;
    const double m = (double)w->bodies.mass[i], r = (double)w->bodies.pos[4*i + 3];
    double lo[3], size[3];
    size_t cell = 0;
    int k;
    lo[0] = (double)d->box.lo.x; lo[1] = (double)d->box.lo.y; lo[2] = (double)d->box.lo.z;
    size[0] = ((double)d->box.hi.x - lo[0])/d->cells[0];
    size[1] = ((double)d->box.hi.y - lo[1])/d->cells[1];
    size[2] = ((double)d->box.hi.z - lo[2])/d->cells[2];
    for (k = 2; k >= 0; k--) {
        const double t = floor((x[k] - lo[k])/size[k]);
        if (!(t >= 0 && t < d->cells[k])) return;
        cell = cell*(size_t)d->cells[k] + (size_t)t;
    }
    field->solid[cell] += (w->desc.planar ? DEMI_PI*r*r*size[2]
        : m/(double)w->materials[w->bodies.material[i] - 1].density)/(size[0]*size[1]*size[2]);
    field->mass[cell] += m;
    for (k = 0; k < 3; k++) field->momentum[3*cell + (size_t)k] += m*(double)w->bodies.vel[4*i + k];
}
/* In a periodic world a body is in a field wherever one of its images is: once, unless the field is
   longer than the period. */
static void demi_fields_sample(dem_world *w) {
    const demi_periods p = demi_periods_of(w);
    int f, i, k;
    for (f = 0; f < w->field_count; f++) {
        demi_field *field = &w->fields[f];
        const dem_field_desc *d = &field->desc;
        dem_real lo[3], hi[3];
        int images[3], n;
        if (!field->used || w->clock.time < field->next ||
            (d->end > 0 && w->clock.time > d->end)) continue;
        field->next = d->interval > 0 ? DEMI_MAX(field->next + d->interval, w->clock.time)
            : w->clock.time +
            100*(double)w->clock.dt;
        if (field->next <= w->clock.time) field->next = w->clock.time + (double)w->clock.dt/2;
        demi_put(lo, d->box.lo);
        demi_put(hi, d->box.hi);
        for (k = 0; k < 3; k++) {
            const double sides = p.period[k] > 0 ? (double)((hi[k] - lo[k])/p.period[k]) : 0;
            images[k] = (int)DEMI_MIN(ceil(DEMI_MAX(sides - 1e-6, 1e-6)), 100);
        }
        for (i = 0; i < w->bodies.count; i++) {
            if (demi_is_ghost(w, i)) continue;
            for (n = 0; n < images[0]*images[1]*images[2]; n++) {
                double x[3];
                for (k = 0; k < 3; k++)
                    x[k] = (double)demi_into(w->bodies.pos[4*i + k], lo[k], p.period[k]) +
                        (double)p.period[k]*(k == 0 ? n%images[0] : k == 1 ? n/images[0]%images[1]
                                             : n/images[0]/images[1]);
                demi_field_add(w, field, i, x);
            }
        }
        field->samples++;
    }
}

/* Time after one more step. */
static void demi_time_pass(dem_world *w) {
    const double dt = (double)w->clock.dt;
    if (w->clock.since.dt < dt || w->clock.since.dt > dt) {
        w->clock.since.time = w->clock.time;
        w->clock.since.steps = w->clock.steps;
        w->clock.since.dt = dt;
    }
    w->clock.steps++;
    w->clock.time = w->clock.since.time + (double)(w->clock.steps - w->clock.since.steps)*dt;
}
/* 1 move: first half kick, drift, predicted velocities; walls follow. */
static dem_result demi_step_move(dem_world *w) {
    double speed2 = 0, acceleration2 = 0, turn = 0, turn_speed = 0, turn_rate = 0;
    int d, i;
    w->clock.half_kick = (double)w->clock.dt/2;
    demi_parallel(w, w->desc.threads, w->domain_count, demi_domain_move);
    w->stage.synced = 0;
    demi_time_pass(w);
    for (d = 0; d < w->domain_count; d++) {
        const double s = w->domains[d].check;
        if (!(s < 1e300) || (DEMI_SINGLE && !(s < 1e37))) return demi_unstable(w);
        speed2 = DEMI_MAX(speed2, w->domains[d].speed2);
        acceleration2 = DEMI_MAX(acceleration2, w->domains[d].acceleration2);
        turn = DEMI_MAX(turn, w->domains[d].turn);
        turn_speed = DEMI_MAX(turn_speed, w->domains[d].turn_speed);
        turn_rate = DEMI_MAX(turn_rate, w->domains[d].turn_rate);
    }
    /* series end there */
    if (sqrt(turn_rate)*(double)w->clock.dt > (w->desc.allow_large_dt ? 2 : 1))
        return demi_spins_refuse(w, sqrt(turn_rate), "dem_world_step");
    w->booked.speed_max = sqrt(speed2);
    w->margin.step_gone =
        (w->booked.speed_max + (w->effects.tight ? sqrt(turn_speed) : 0))*(double)w->clock.dt;
    w->margin.gone += w->margin.step_gone;
    w->margin.last_change = sqrt(acceleration2)*(double)w->clock.dt + sqrt(turn);
    if (w->desc.ledger) {
        const double work = demi_sum_energy(w, DEMI_E_GRAVITY);
        w->booked.energy[DEMI_E_GRAVITY] += work;
        w->booked.throughput += fabs(work);
    }
    for (i = 0; i < w->wall_count; i++) {
        demi_wall *wall = &w->walls[i];
        dem_pose pose = wall->pose, mid = wall->mid;
        double speed;
        if (wall->kind == DEMI_WALL_NONE || wall->motion.kind == DEM_MOTION_FIXED) continue;
        demi_wall_pose_at(wall, w->clock.time, &pose);
        demi_wall_pose_at(wall, w->clock.time - w->clock.half_kick, &mid);
        if (!demi_pose_finite(&pose) || !demi_pose_finite(&mid)) {
            w->stage.forces_valid = 0;          /* the wall stays where it was, finite */
            w->margin.walls_gone = 1e300;
            return demi_fail(w, DEM_ERROR_UNSTABLE, "dem_world_step: step %llu: the motion of wall "
                             "%d gave a pose that is not finite at %g s; check the motion function",
                             (unsigned long long)w->clock.steps, i + 1, w->clock.time);
        }
        wall->pose = pose;
        wall->mid = mid;
        speed = demi_wall_speed(wall);
        if (speed < 0) w->margin.walls_gone = 1e300;   /* no bound: look anew */
        else w->wall_fastest = DEMI_MAX(w->wall_fastest, speed);
    }
    w->margin.walls_gone += w->wall_fastest*(double)w->clock.dt;
    w->wall_fastest = 0;
    return DEM_OK;
}

/* One step. Numbers as in the manual. A step that ran out of memory after its move goes on from
   there. */
static dem_result demi_step_once(dem_world *w) {
    double overlap = 0;
    dem_result result;
    int d, search;
    if (!w->stage.moved) {
        result = demi_step_move(w);
        if (result != DEM_OK) return result;
        demi_near_pass(w, w->margin.last_change);
        w->stage.moved = 1;
    }
    /* 2 search: when something may have come near that is not in the list. Outlets look then:
       nobody gets farther than half a skin between two lists */
    result = demi_outflow(w);
    search = !w->stage.list_valid || w->margin.skin <= 0 || 2*w->margin.gone > w->margin.skin ||
             w->margin.gone + w->margin.walls_gone > w->margin.skin;
    if (result == DEM_OK && w->outlet_count && (search || w->clock.steps%DEMI_OUTLET_REST == 0))
        result = demi_outlets_run(w);
    if (result != DEM_OK) return result;
    if (search || !w->stage.list_valid) {
        result = demi_rebuild(w, "dem_world_step");
        if (result != DEM_OK) return result;
        demi_kernel_choose(w);
        /* grains are faster than the step was chosen for: choose it anew */
        if (w->booked.speed_max > 1.5*w->clock.assumed_speed) w->stage.dt_valid = 0;
    } else if (w->stage.near_stale || demi_near_due(w)) {
        if (!w->stage.near_chosen && demi_near_due(w)) demi_near_choose(w);
        w->stage.near_chosen = 1;
        if (!demi_near_make(w, 0)) return demi_no_memory(w, "dem_world_step");
        w->stage.near_chosen = 0;
    }

    /* 3 touch, 4 respond, 5 gather */
    if (!demi_touch(w)) return demi_no_memory(w, "dem_world_step");
    demi_forces(w);
    w->stage.moved = 0;
    for (d = 0; d < w->domain_count && demi_own(w); d++)
        if (!(w->domains[d].check < 1e300)) return demi_unstable(w);

    /* 6 kick: the second half kick waits until somebody looks or the next step begins (demi_finish)
       */
    for (d = 0; d < w->domain_count; d++) overlap = DEMI_MAX(overlap, w->domains[d].overlap);
    if (!(overlap < 1)) return demi_unstable(w);
    return DEM_OK;
}

/* Something changed since the last step: forces at t, by a new list if need be; memory stays. */
static dem_result demi_refresh(dem_world *w) {
    dem_result result;
    demi_finish(w);
    if (w->stage.pairs_changed) {               /* half steps were of the old forces, and effects */
        w->stage.primed = 0;
        if (!demi_list_drop(w)) return demi_no_memory(w, "dem_world_step");
    }
    if (!w->stage.list_valid) {
        result = demi_rebuild(w, "dem_world_step");
        if (result != DEM_OK) return result;
    }
    w->stage.pairs_changed = 0;
    demi_kernel_choose(w);
    w->stage.forces_valid = 0;
    if (!demi_touch(w)) return demi_no_memory(w, "dem_world_step");
    demi_forces(w);
    w->stage.forces_valid = 1;
    return DEM_OK;
}

DEM_API dem_result dem_world_step(dem_world *w, int steps) {
    if (demi_null(w, "dem_world_step", w, "world")) return DEM_ERROR_ARGUMENT;
    dem_result result = DEM_OK;
    int i, f, whole = 1;
    if (steps < 0)
        return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_world_step: steps is %d, must be >= 0", steps);
    if (steps && demi_unbuilt(w, "dem_world_step") != DEM_OK) return DEM_ERROR_ARGUMENT;
    for (i = 0; i < steps && result == DEM_OK; i++) {
        int sampling = 0;
        if (!w->stage.moved) {
            result = demi_dt_settle(w);
            if (result == DEM_OK && w->feed_count) {
                result = demi_world_feed(w);
                if (result == DEM_OK) result = demi_dt_settle(w);   /* there may be new grains */
            }
            if (result == DEM_OK &&
                (!w->stage.forces_valid || !w->stage.list_valid || w->stage.pairs_changed))
                result = demi_refresh(w);
            if (result == DEM_OK) result = demi_dt_check(w);
            if (result != DEM_OK) break;
            if (!w->stage.primed) { demi_finish(w); demi_prime(w); }
        }
        result = demi_step_once(w);
        whole = result == DEM_OK;
        for (f = 0; f < w->field_count; f++)
            sampling |= w->fields[f].used && w->clock.time >= w->fields[f].next;
        if (sampling && whole) { demi_finish(w); demi_fields_sample(w); }
    }
    /* half a step: its velocities stay as predicted */
    if (!whole && w->stage.moved) return result;
    demi_finish(w);
    return result;
}

DEM_API dem_result dem_world_run(dem_world *w, double seconds, dem_progress_fn progress,
                                 void *user) {
    if (demi_null(w, "dem_world_run", w, "world")) return DEM_ERROR_ARGUMENT;
    const double start = w->clock.time, begun = demi_clock();
    double last = begun, end;
    int chunk = 1;
    if (!demi_finite_double(seconds) || !(seconds >= 0) || !(seconds < 1e300))
        return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_world_run: seconds is %g, must be finite and "
                         ">= 0", seconds);
    if (demi_unbuilt(w, "dem_world_run") != DEM_OK) return DEM_ERROR_ARGUMENT;
    end = start + seconds;
    if (w->clock.run_steps == w->clock.steps &&
        fabs(w->clock.run_end - start) <= (double)w->clock.dt)
        end = w->clock.run_end + seconds;
    for (;;) {
        const double left = end - w->clock.time;
        double now;
        int steps = chunk;
        dem_result result = demi_dt_settle(w);
        if (result != DEM_OK) return result;
        if (left < (double)w->clock.dt/2) break;
        if (left/(double)w->clock.dt < chunk) steps = (int)(left/(double)w->clock.dt + 0.5);
        if (steps < 1) steps = 1;
        result = dem_world_step(w, steps);
        if (result != DEM_OK) return result;
        now = demi_clock();
        if (now - last > 0.1 && progress) {
            const double done = (w->clock.time - start)/seconds;
            last = now;
            if (progress(w, done, (now - begun)*(1 - done)/DEMI_MAX(done, 1e-9), user))
                return demi_fail(w, DEM_ERROR_STOPPED, "dem_world_run: stopped by the progress "
                                 "function at %g s", w->clock.time);
        }
        /* short steps: look at the clock less often */
        if (now - begun < 0.05*(double)w->clock.steps && chunk < 1000) chunk++;
    }
    w->clock.run_end = end;
    w->clock.run_steps = w->clock.steps;
    if (progress) progress(w, 1, 0, user);
    return DEM_OK;
}

DEM_API int dem_progress_print(const dem_world *w, double done, double seconds_left, void *user) {
    if (demi_null(w, "dem_progress_print", user, "user")) return 0;
    fprintf((FILE *)user, "\r%5.1f %%  t = %-10.4g s  %d grains  %.0f s left   %s", 100*done,
            w->clock.time, w->bodies.count,
            seconds_left, done >= 1 ? "\n" : "");
    fflush((FILE *)user);
    return 0;
}

DEM_API double dem_world_time(const dem_world *w) {
    if (demi_null(w, "dem_world_time", w, "world")) return 0;
    return w->clock.time;
}
DEM_API uint64_t dem_world_steps(const dem_world *w) {
    if (demi_null(w, "dem_world_steps", w, "world")) return 0;
    return w->clock.steps;
}

/* ---------------------------------------------------------------------------------------------
   >>measure
   Looking at a world without changing it: fields on a grid, counters, contacts, the digest.
   --------------------------------------------------------------------------------------------- */
DEM_API dem_field dem_field_add(dem_world *w, const dem_field_desc *d) {
    if (demi_null(w, "dem_field_add", d, "desc")) return demi_no_field;
    dem_field id;
    demi_field field;
    size_t n;
    id.id = 0;
    if (d->cells[0] < 1 || d->cells[1] < 1 || d->cells[2] < 1 ||
        (double)d->cells[0]*d->cells[1]*d->cells[2] > 268435456.0 || !(d->box.hi.x > d->box.lo.x) ||
        !(d->box.hi.y > d->box.lo.y) || !(d->box.hi.z > d->box.lo.z) ||
        !demi_finite3(d->box.lo) || !demi_finite3(d->box.hi) || !(d->interval >= 0) ||
        !(d->start >= 0) || !demi_finite_double(d->interval) || !demi_finite_double(d->start) ||
        !demi_finite_double(d->end)) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "dem_field_add: cells are %d x %d x %d, interval %g s; "
                  "must be >= 1 each and at most "
                  "2^28 in all, the box finite with lo below hi, times finite and >= 0",
                  d->cells[0], d->cells[1], d->cells[2], d->interval);
        return id;
    }
    memset(&field, 0, sizeof field);
    field.used = 1;
    field.desc = *d;
    field.next = d->start;
    n = demi_field_cells(&field);
    field.solid = (double *)demi_hold(w, DEMI_RUN, n, sizeof(double));
    field.mass = (double *)demi_hold(w, DEMI_RUN, n, sizeof(double));
    field.momentum = (double *)demi_hold(w, DEMI_RUN, n, 3*sizeof(double));
    if (!field.solid || !field.mass || !field.momentum ||
        !DEMI_GROW(w, w->fields, (size_t)w->field_count + 1)) {
        demi_free(w, field.solid);
        demi_free(w, field.mass);
        demi_free(w, field.momentum);
        demi_no_memory(w, "dem_field_add");
        return id;
    }
    w->fields[w->field_count++] = field;
    demi_built(w, "dem_field_add");
    id.id = w->field_count;
    return id;
}
/* From an id to a field, or a sentence in the name of `call`. */
static demi_field *demi_field_find(dem_world *w, const char *call, dem_field id) {
    if (id.id >= 1 && id.id <= w->field_count) return &w->fields[id.id - 1];
    demi_fail(w, DEM_ERROR_ARGUMENT, "%s: field %d does not exist, there are %d", call,
              (int)id.id, w->field_count);
    return 0;
}
DEM_API dem_result dem_field_get(const dem_world *w, dem_field id, dem_field_data *data) {
    if (demi_null(w, "dem_field_get", data, "data")) return DEM_ERROR_ARGUMENT;
    const demi_field *f = demi_field_find((dem_world *)w, "dem_field_get", id);
    if (!f) return DEM_ERROR_ARGUMENT;
    memcpy(data->cells, f->desc.cells, sizeof data->cells);
    data->box = f->desc.box;
    data->samples = f->samples;
    data->solid = f->solid;
    data->mass = f->mass;
    data->momentum = f->momentum;
    return DEM_OK;
}
DEM_API dem_result dem_field_reset(dem_world *w, dem_field id) {
    if (demi_null(w, "dem_field_reset", w, "world")) return DEM_ERROR_ARGUMENT;
    demi_field *f = demi_field_find(w, "dem_field_reset", id);
    size_t n;
    if (!f) return DEM_ERROR_ARGUMENT;
    n = demi_field_cells(f);
    memset(f->solid, 0, n*sizeof(double));
    memset(f->mass, 0, n*sizeof(double));
    memset(f->momentum, 0, 3*n*sizeof(double));
    f->samples = 0;
    return DEM_OK;
}

DEM_API dem_counters dem_counters_get(const dem_world *w) {
    dem_counters c;
    int d;
    memset(&c, 0, sizeof c);
    if (!w) return c;
    c.steps = w->clock.steps;
    c.rebuilds = w->clock.rebuilds;
    for (d = 0; d < w->domain_count && w->stage.list_valid; d++) {
        c.candidates += w->domains[d].own + w->domains[d].cross;
        c.contacts += w->domains[d].contacts;
        c.wall_contacts += w->domains[d].kept_walls;
    }
    c.overlap_max = (dem_real)w->booked.overlap_max;
    c.speed_max = (dem_real)w->booked.speed_max;
    c.skin = (dem_real)w->margin.skin;
    c.dt = w->clock.dt;
    c.search = w->desc.search;
    c.threads = w->desc.threads;
    c.domains = w->domain_count;
    c.memory = w->bytes;
    return c;
}
DEM_API void dem_overlap_reset(dem_world *w) {
    if (demi_null(w, "dem_overlap_reset", w, "world")) return;
    w->booked.overlap_max = 0;
}

/* One near pair, if it touches: its force by the law of the run on a copy of its memory. */
static int demi_contact_force(const dem_world *w, int d, int p, dem_contact_info *out) {
    demi_run r = demi_run_of(w, 0, w->effects.uniform);
    const demi_span span = demi_span_of(w, d, p, 1);
    const int a = span.a[0], b = span.b[0];
    const demi_periods periods = demi_periods_of(w);
    dem_real memory[DEMI_MEMORY], coef[DEMI_PAIR_COLUMNS];
    demi_tile tile;
    dem_contact c;
    dem_contact_force f;
    dem_vec3 gap;
    int e;
    r.span = &span;
    demi_tile_fetch(&r, 1, &tile);
    gap = demi_rows_at(&tile.gap, 0);
    demi_touch_one(&tile, &r.same, 0, r.alike);
    if (!(tile.touch[0] > 0)) return 0;
    if (!out) return 1;
    for (e = 0; e < r.keep; e++) memory[e] = span.memory[(size_t)e*span.stride];
    demi_span_coefs(w, &span, 0, coef);
    for (e = 0; e < DEMI_PAIR_COLUMNS; e++) tile.coef[e][0] = coef[e];
    demi_motion_one(&tile, &r.same, 0, r.alike, r.turning, r.following);
    demi_tile_contact(&tile, &r.same, 0, &c);
    c.material_a = w->bodies.material[a];
    c.material_b = w->bodies.material[b];
    c.user = w->desc.law_user;
    demi_law(w, &c, memory, &f);
    demi_answer_one(&tile, 0, f.normal, f.tangent, f.moment, r.alike, r.turning, r.parting);
    out->a = dem_bodies_id(w, a);
    out->b = dem_bodies_id(w, b);
    out->wall = 0;
    out->normal = demi_row(tile.normal, 0);
    out->overlap = tile.overlap[0];
    gap = demi_scale(gap, w->bodies.pos[4*a + 3]/(w->bodies.pos[4*a + 3] + w->bodies.pos[4*b + 3]));
    out->point = demi_place_of(&periods, demi_add(demi_at(w->bodies.pos + 4*a), gap));
    out->force = demi_row(tile.force, 0);
    return 1;
}
DEM_API int dem_contacts_get(const dem_world *w, dem_contact_info *out, int capacity) {
    if (demi_null(w, "dem_contacts_get", w, "world")) return -1;
    const demi_periods p = demi_periods_of(w);
    dem_vec3 x;
    int d, k, n = 0;
    if (!w->stage.list_valid) return demi_list_stale(w, "dem_contacts_get");
    for (d = 0; d < w->domain_count; d++) {
        const demi_domain *domain = &w->domains[d];
        for (k = demi_near_first(domain); k < domain->near_end; k = demi_near_next(domain, k))
            n += demi_contact_force(w, d, k, n < capacity && out ? &out[n] : 0);
        for (k = 0; k < w->domains[d].kept; k++) {
            const demi_kept *c = demi_kept_of(w, d) + k;
            if (!(c->overlap > 0) || ++n > capacity || !out) continue;
            out[n - 1].a = dem_bodies_id(w, c->a);
            out[n - 1].b = dem_bodies_id(w, c->b);
            out[n - 1].wall = c->b < 0 ? c->wall + 1 : 0;
            out[n - 1].normal = c->normal;
            x = demi_add(demi_at(w->bodies.pos + 4*c->a), c->arm_a);
            if (c->b < 0) x = demi_sub(x, demi_scale(c->normal, c->overlap));
            out[n - 1].point = demi_place_of(&p, x);
            out[n - 1].overlap = c->overlap;
            out[n - 1].force = c->force;
        }
    }
    return n;
}

/* Digest of contact memory, reals a `stride` apart, turned round or not. Told is what is not 0 and
   belongs to an effect of the scene, with a number that does not depend on which other laws are in
   force: so it does not matter whether a list has been made since friction came or went. *any: is
   there something to tell? */
static uint64_t demi_memory_hash(const dem_world *w, uint64_t h, const dem_real *memory,
                                 size_t stride, int flip, int *any) {
    const demi_laws *laws = &w->laws;
    int i, friction = 1, rolling = 1;
    *any = 0;
    if (!w->desc.law && w->memory_stride) demi_pairs_rub(w, &friction, &rolling);
    for (i = 0; i < w->memory_stride; i++) {
        dem_real m = memory[(size_t)i*stride];
        int number = i;
        if (!w->desc.law) {
            if (i < laws->at_rolling ? !friction : i < laws->at_normal && !rolling) continue;
            if (i >= laws->at_normal) number = 2*DEMI_MEMORY + i - laws->at_normal;
            else if (i >= laws->at_rolling) number = DEMI_MEMORY + i - laws->at_rolling;
        }
        if (!(m < 0) && !(m > 0)) continue;
        if (flip && (w->vector_mask >> i & 1)) m = -m;
        h = demi_hash(demi_hash(h, &number, sizeof number), &m, sizeof m);
        *any = 1;
    }
    return h;
}
/* Memory of two spheres, the same whichever of them is a; 0 when there is nothing to remember. */
static uint64_t demi_pair_digest(const dem_world *w, uint32_t sa, uint32_t sb,
                                 const dem_real *memory, size_t stride) {
    const uint32_t lo = DEMI_MIN(sa, sb), hi = DEMI_MAX(sa, sb);
    uint64_t one = demi_hash(DEMI_HASH_START, &lo, sizeof lo);
    int any;
    one = demi_memory_hash(w, demi_hash(one, &hi, sizeof hi), memory, stride, sa > sb, &any);
    return any ? one : 0;
}
/* Digest of one contact, whichever of its bodies is a. */
static uint64_t demi_kept_hash(const dem_world *w, const demi_kept *c) {
    const int pushes = c->share > 0, slots = !w->stage.list_valid;   /* while there is no list */
    uint32_t who[4];
    uint64_t h = DEMI_HASH_START;
    int i, flip;
    who[0] = slots ? (uint32_t)c->a : w->bodies.slot[c->a];
    who[1] = c->b < 0 ? (uint32_t)c->element : slots ? (uint32_t)c->b : w->bodies.slot[c->b];
    who[2] = (uint32_t)c->part_a;
    who[3] = c->b >= 0 ? (uint32_t)c->part_b : (uint32_t)c->wall;
    flip = c->b >= 0 && who[0] > who[1];
    for (i = 0; i < 4; i++) h = demi_hash(h, &who[flip ? i ^ 1 : i], sizeof *who);
    h = demi_hash(h, &pushes, sizeof pushes);
    return demi_memory_hash(w, h, c->memory, 1, flip, &i);
}
/* Contacts as a sum of their own digests, in which neither their order tells nor whether there is a
   list or they are on their way to the next one. */
static uint64_t demi_contacts_hash(const dem_world *w, uint64_t h) {
    uint64_t sum = 0;
    int d, k, i;
    for (d = 0; d < w->domain_count; d++) {
        const demi_domain *domain = &w->domains[d];
        for (k = w->stage.list_valid ? demi_near_first(domain)
             : domain->near_end; k < domain->near_end;
             k = demi_near_next(domain, k)) {
            const demi_span span = demi_span_of(w, d, k, 1);
            if (demi_near_remembers(w, d, k))
                sum += demi_pair_digest(w, w->bodies.slot[span.a[0]], w->bodies.slot[span.b[0]],
                                        span.memory, span.stride);
        }
        for (k = 0; k < domain->kept; k++)
            sum += demi_kept_hash(w, demi_kept_of(w, d) + k);
    }
    for (i = 0; !w->stage.list_valid && w->filed.count && w->filed.stride == w->memory_stride &&
                i < w->filed.rows; i++)
        for (k = w->filed.start[i]; k < w->filed.start[i + 1]; k++) {
            const int32_t p = w->filed.partner[k];
            const uint32_t row = (uint32_t)i, other = (uint32_t)(p < 0 ? ~p : p);
            sum += demi_pair_digest(w, p < 0 ? other : row, p < 0 ? row : other,
                                    w->filed.memory + (size_t)k*(size_t)w->filed.stride, 1);
        }
    return demi_hash(h, &sum, sizeof sum);
}

/* Contact k of domain d: whose it is; and when it is one with this wall, 1, its normal and its
   friction. */
static int demi_wall_press(const dem_world *w, int d, int k, int wall, int *body, dem_vec3 *normal,
                           dem_real *mu) {
    const demi_kept *c = demi_kept_of(w, d) + k;
    *body = c->a;
    *normal = c->normal;
    *mu = demi_static_friction(w, w->bodies.material[c->a] - 1, w->walls[wall].material);
    return c->b < 0 && c->wall == wall;
}
/* Contacts of one grain follow each other. Stuck: two of them push against each other in the
   sieve's plane (their parts in it point apart), and both are flatter than friction's angle:
   |n_z| <= mu |n_xy|. */
DEM_API int dem_sieve_blinded(const dem_world *w, dem_wall sieve, dem_real speed) {
    if (demi_null(w, "dem_sieve_blinded", w, "world")) return -1;
    const int id = demi_wall_find((dem_world *)w, "dem_sieve_blinded", sieve);
    const demi_wall *wall = id < 0 ? 0 : &w->walls[id];
    dem_vec3 across, n, m;
    dem_real mu, mu_m;
    int d, k, j, body, same, count = 0;
    if (!wall) return -1;
    if (!wall->sieve.kind) {
        demi_fail((dem_world *)w, DEM_ERROR_ARGUMENT, "dem_sieve_blinded: wall %d is not a sieve; "
                  "give what dem_sieve_add returned", (int)sieve.id);
        return -1;
    }
    if (!w->stage.list_valid) return demi_list_stale(w, "dem_sieve_blinded");
    across = demi_v(wall->pose.rotation[2], wall->pose.rotation[5], wall->pose.rotation[8]);
    for (d = 0; d < w->domain_count; d++) {
        const int all = w->domains[d].kept;
        int last = -1;                          /* the grain counted last: once is enough */
        for (k = 0; k < all; k++) {
            dem_vec3 v, flat;
            dem_real z;
            if (!demi_wall_press(w, d, k, id, &body, &n, &mu) || body == last) continue;
            v = demi_sub(demi_at(w->bodies.vel + 4*body), demi_add(wall->pose.velocity,
                demi_cross(wall->pose.spin, demi_sub(demi_at(w->bodies.pos + 4*body),
                                                     wall->pose.position))));
            z = demi_dot(n, across);
            flat = demi_sub(n, demi_scale(across, z));
            if ((speed > 0 && demi_length(v) > speed) || z*z > mu*mu*(1 - z*z)) continue;
            for (j = k + 1; j < all && last != body; j++) {
                const int here = demi_wall_press(w, d, j, id, &same, &m, &mu_m);
                if (same != body) break;
                z = demi_dot(m, across);
                if (here && z*z <= mu_m*mu_m*(1 - z*z) && demi_dot(flat, m) < DEM_R(-0.25)) {
                    count++;
                    last = body;
                }
            }
        }
    }
    return count;
}

/* Bodies in the order of their slots, so that the digest does not hang on the order of the arrays;
   contact memory as a sum over contacts of their own digests, for the same reason. */
DEM_API uint64_t dem_world_hash(const dem_world *w) {
    if (demi_null(w, "dem_world_hash", w, "world")) return 0;
    const demi_periods p = demi_periods_of(w);
    uint64_t h = DEMI_HASH_START;
    int i;
    h = demi_hash(h, &w->clock.time, sizeof w->clock.time);
    for (i = 0; i < w->bodies.slot_count; i++) {
        const int b = w->bodies.slot_index[i];
        dem_real x[4];
        if (b < 0) continue;
        /* a new list puts them there */
        demi_put(x, demi_place_of(&p, demi_at(w->bodies.pos + 4*b)));
        x[3] = w->bodies.pos[4*b + 3];
        h = demi_hash(h, &i, sizeof i);
        h = demi_hash(h, x, sizeof x);
        h = demi_hash(h, w->bodies.vel + 4*b, 3*sizeof(dem_real));
        h = demi_hash(h, w->bodies.spin + 4*b, 3*sizeof(dem_real));
        if (!w->bodies.orienting) continue;
        h = demi_hash(h, w->bodies.orient + 4*b, 4*sizeof(dem_real));
        h = demi_hash(h, w->bodies.angular + 4*b, 3*sizeof(dem_real));
    }
    for (i = 0; i < w->wall_count; i++)
        if (w->walls[i].kind != DEMI_WALL_NONE) {
            h = demi_hash(h, &w->walls[i].pose.position, sizeof(dem_vec3));
            h = demi_hash(h, w->walls[i].pose.rotation, sizeof w->walls[i].pose.rotation);
        }
    for (i = 0; i < w->feed_count; i++) {
        const demi_feed *f = demi_feed_at(w, i);
        const int64_t next = f->next;
        h = demi_hash(h, &f->random, sizeof f->random);
        h = demi_hash(h, &next, sizeof next);
        h = demi_hash(h, f->state.fed, sizeof f->state.fed);
    }
    for (i = 0; i < w->outlet_count; i++) {
        const dem_outlet_state *o = &demi_outlet_at(w, i)->state;
        h = demi_hash(h, o->count, sizeof o->count);
        h = demi_hash(h, &o->total, sizeof o->total);
    }
    return demi_contacts_hash(w, h);
}

/* ---------------------------------------------------------------------------------------------
   >>read
   Files in. A file is loaded whole and goes to the parser that also serves data in memory. Its
   bytes are not to be trusted: nothing is read past the end, a count is held against the bytes
   there before memory is taken for it, and errors name the line. Text is read by moving
   (demi_text_line, demi_text_word) and looking at the present word (demi_text_is, _real, _corner).
   OBJ and STL text have no counts, so they are gone through twice: to count, then to fill arrays of
   the right size.

   demi_first_equal says of each of many keys where it came first. Merging vertices, counting the
   triangles of an edge and finding doubled triangles are all this one question.
   ---------------------------------------------------------------------------------------------- */
#include <errno.h>

#define DEMI_ELEMENTS_MAX 700000000 /* vertices, triangles: three times as many fit an int32      */

/* ---- text in ---- */

/* A text being read, without a zero at its end, and what an error sentence needs. */
typedef struct demi_text {
    dem_world *world;
    const char *call, *name;    /* the public function; the file or data it reads                 */
    const char *word;           /* the present word; null at the end of the text                  */
    size_t length;              /* of the word; 0 at the end of a line                            */
    const char *at, *line_end;  /* what is left of the line                                       */
    const char *next, *end;     /* what is left after it                                          */
    const char *data;           /* where all of it begins                                         */
    long line;                  /* counted from 1                                                 */
    char half[24];              /* 0.5 in this locale: strtod wants its decimal point             */
} demi_text;

/* A text at its beginning. Numbers in it have a point, whatever the locale says: `half` learns what
   that puts between digits. */
static demi_text demi_text_make(dem_world *w, const char *call, const char *name, const char *data,
                                size_t size) {
    demi_text t;
    size_t length = name ? strlen(name) : 0;
    memset(&t, 0, sizeof t);
    t.world = w;
    t.call = call;
    t.name = !name ? "data" : length > 200 ? name + (length - 200) : name;
    t.data = data;
    t.end = data + size;
    t.next = size >= 3 && memcmp(data, "\xEF\xBB\xBF", 3) == 0 ? data + 3 : data; /* order mark */
    t.at = t.line_end = t.next;
    if (snprintf(t.half, sizeof t.half, "%.1f", 0.5) < 3) memcpy(t.half, "0.5", 4);
    return t;
}

/* Moves to the next word of the line; 0 when there is none. */
static int demi_text_word(demi_text *t) {
    const char *p = t->at;
    while (p < t->line_end && (*p == ' ' || *p == '\t' || *p == '\v' || *p == '\f')) p++;
    t->word = p;
    while (p < t->line_end && !(*p == ' ' || *p == '\t' || *p == '\v' || *p == '\f')) p++;
    t->at = p;
    t->length = (size_t)(p - t->word);
    return t->length > 0;
}

/* Moves to the first word of the next line that has one; 0 at the end. # begins a comment. */
static int demi_text_line(demi_text *t) {
    while (t->next < t->end) {
        const char *p = t->next, *comment;
        t->at = p;
        t->line++;
        while (p < t->end && *p != '\n' && *p != '\r') p++;
        comment = (const char *)memchr(t->at, '#', (size_t)(p - t->at));
        t->line_end = comment ? comment : p;
        if (p < t->end) p += *p == '\r' && t->end - p > 1 && p[1] == '\n' ? 2 : 1;
        t->next = p;
        if (demi_text_word(t)) return 1;
    }
    t->at = t->line_end = t->end;
    t->word = 0;
    t->length = 0;
    return 0;
}

/* Refuses the present word; `where` says what is allowed and what to do. */
static dem_result demi_text_fail(const demi_text *t, const char *where) {
    char shown[44] = "'";
    size_t i, length = t->length < 40 ? t->length : 40;
    for (i = 0; i < length; i++)
        shown[i + 1] = (char)(t->word[i] >= 32 && t->word[i] < 127 ? t->word[i] : '?');
    shown[length + 1] = '\'';
    return demi_fail(t->world, DEM_ERROR_FORMAT, "%s: %s line %ld: found %s where %s", t->call,
                     t->name, t->line, t->length ? shown : t->word ? "the end of the line" :
                     "the end of the file", where);
}

static dem_result demi_text_memory(const demi_text *t) {
    return demi_fail(t->world, DEM_ERROR_MEMORY, "%s: %s: no memory for what it holds; free some "
                     "or simplify the mesh", t->call, t->name);
}

/* 1 if the present word is this one (given in lower case), in capitals or not. */
static int demi_text_is(const demi_text *t, const char *word) {
    size_t i;
    if (t->length != strlen(word)) return 0;
    for (i = 0; i < t->length; i++) {
        char c = t->word[i];
        if ((c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c) != word[i]) return 0;
    }
    return 1;
}

/* The present word as a coordinate: a decimal number with a point, no nan, inf or hexadecimal.
   strtod rounds correctly, but needs a zero at the end and the locale's point: hence the copy. */
static dem_result demi_text_real(demi_text *t, dem_real *value) {
    char copy[160], *end = copy;
    size_t i, n = 0, point = strlen(t->half) - 2;
    int points = 0, bad = t->length == 0 || t->length > 120;
    double number = 0;
    for (i = 0; i < t->length && !bad; i++) {
        char c = t->word[i];
        if (c == '.' && points++ == 0) {
            memcpy(copy + n, t->half + 1, point);
            n += point;
        } else {
            bad = !(c >= '0' && c <= '9') && c != '+' && c != '-' && c != 'e' && c != 'E';
            copy[n++] = c;
        }
    }
    copy[bad ? 0 : n] = 0;
    if (!bad) number = strtod(copy, &end);
    if (bad || end != copy + n || number > DEMI_FARTHEST || number < -DEMI_FARTHEST)
        return demi_text_fail(t, "a coordinate is expected, a decimal number within +-1e15 (m); "
                              "correct it or export the file again");
    *value = (dem_real)number;
    if (*value == 0) *value = 0; /* -0 and 0 are one place */
    return DEM_OK;
}

/* The first `length` bytes of the present word as a whole number of at most 9 digits. */
static int demi_text_integer(const demi_text *t, size_t length, int32_t *value) {
    size_t i = length > 0 && (t->word[0] == '-' || t->word[0] == '+') ? 1 : 0;
    int32_t number = 0;
    if (length == i || length - i > 9) return 0;
    for (; i < length; i++) {
        if (t->word[i] < '0' || t->word[i] > '9') return 0;
        number = 10*number + (t->word[i] - '0');
    }
    *value = t->word[0] == '-' ? -number : number;
    return 1;
}

/* The present word as a corner from 1 to count, handed back from 0. In OBJ (back > 0) what follows
   a slash is passed over, and -1 is the last of the `back` vertices read so far. */
static dem_result demi_text_corner(const demi_text *t, int count, int back, int32_t *corner) {
    char where[160];
    const char *slash = t->length && back > 0 ? (const char *)memchr(t->word, '/', t->length) : 0;
    if (demi_text_integer(t, slash ? (size_t)(slash - t->word) : t->length, corner)) {
        if (*corner < 0 && back > 0) *corner += back + 1;
        if (*corner >= 1 && *corner <= count) {
            --*corner;
            return DEM_OK;
        }
    }
    snprintf(where, sizeof where, "a corner is expected, a whole number from 1 to %d, the number "
             "of vertices; correct it or export the file again", count);
    return demi_text_fail(t, where);
}

/* ---- meshes and profiles in: width is 3 for triangles in space, 2 for segments in a plane ---- */

static void demi_mesh_free(dem_world *w, dem_mesh *mesh) {
    demi_free(w, mesh->vertices);
    demi_free(w, mesh->triangles);
    memset(mesh, 0, sizeof *mesh);
}

/* Arrays for counts that are known and backed by bytes. On failure the caller frees. */
static dem_result demi_mesh_allocate(const demi_text *t, dem_mesh *mesh, size_t width,
                                     size_t vertices, size_t elements) {
    if (vertices == 0 || elements == 0 || elements > DEMI_ELEMENTS_MAX ||
        vertices > 3*(size_t)DEMI_ELEMENTS_MAX)
        return demi_fail(t->world, DEM_ERROR_FORMAT, "%s: %s: found %.0f vertices and %.0f "
                         "triangles where from 1 to %d are allowed; check what was exported",
                         t->call, t->name, (double)vertices, (double)elements, DEMI_ELEMENTS_MAX);
    mesh->vertex_count = (int)vertices;
    mesh->triangle_count = (int)elements;
    mesh->vertices = (dem_real *)demi_alloc(t->world, vertices*width, sizeof(dem_real));
    mesh->triangles = (int32_t *)demi_alloc(t->world, elements*width, sizeof(int32_t));
    return mesh->vertices && mesh->triangles ? DEM_OK : demi_text_memory(t);
}

/* [MIL] Fig 5.11: two counts, a line per vertex, a line of corners per element. */
static dem_result demi_lists_read(demi_text *t, size_t width, dem_mesh *mesh) {
    int32_t count[2] = {0, 0};
    size_t i;
    int k;
    dem_result result;
    for (k = 0; k < 2; k++) {
        if (!(k ? demi_text_word(t) : demi_text_line(t)) ||
            !demi_text_integer(t, t->length, &count[k]) || count[k] < 1 ||
            count[k] > DEMI_ELEMENTS_MAX)
            return demi_text_fail(t, "the numbers of vertices and elements are expected, from 1 to "
                                  "700000000 (or an STL or OBJ file); correct the first line");
    }
    /* a line has two bytes at least, the last maybe one: memory stays in proportion to the file */
    if (2*((uint64_t)count[0] + (uint64_t)count[1]) > (uint64_t)(t->end - t->next) + 1)
        return demi_fail(t->world, DEM_ERROR_FORMAT, "%s: %s line %ld: found counts %ld and %ld, "
                         "but only %.0f bytes follow; copy the file again or correct the counts",
                         t->call, t->name, t->line, (long)count[0], (long)count[1],
                         (double)(t->end - t->next));
    result = demi_mesh_allocate(t, mesh, width, (size_t)count[0], (size_t)count[1]);
    for (k = 0; k < 2; k++)
        for (i = 0; i < (size_t)count[k]*width && result == DEM_OK; i++) {
            if (i%width > 0) demi_text_word(t);
            else if (demi_text_word(t))
                return demi_text_fail(t, "the line should end; give each vertex and each element a "
                                      "line of its own");
            else demi_text_line(t);
            result = k ? demi_text_corner(t, count[0], 0, mesh->triangles + i)
                       : demi_text_real(t, mesh->vertices + i);
        }
    if (result == DEM_OK && (demi_text_word(t) || demi_text_line(t)))
        return demi_text_fail(t, "the file should end; correct the counts in its first line");
    return result;
}

/* OBJ: v and f lines, polygons cut into a fan of triangles, the rest passed over. Without `fill` it
   counts and allocates. The text comes by value: each pass starts afresh. */
static dem_result demi_obj_pass(demi_text t, dem_mesh *mesh, int fill) {
    size_t vertices = 0, triangles = 0, axis;
    dem_result result = DEM_OK;
    while (result == DEM_OK && demi_text_line(&t)) {
        if (demi_text_is(&t, "v")) {
            for (axis = 0; fill && axis < 3 && result == DEM_OK; axis++) {
                demi_text_word(&t);
                result = demi_text_real(&t, &mesh->vertices[3*vertices + axis]);
            }
            vertices++;
        } else if (demi_text_is(&t, "f")) {
            int32_t corner[3] = {0, 0, 0}; /* first, previous, present */
            int count = 0;
            for (; result == DEM_OK && demi_text_word(&t); count++) {
                if (fill)
                    result = demi_text_corner(&t, mesh->vertex_count, (int)vertices, &corner[2]);
                if (fill && count >= 2)
                    memcpy(mesh->triangles + 3*triangles, corner, sizeof corner);
                if (count >= 2) triangles++;
                corner[count == 0 ? 0 : 1] = corner[2];
            }
            if (fill && result == DEM_OK && count < 3)
                result = demi_text_fail(&t, "a face needs three corners or more; complete it or "
                                        "take it out");
        }
    }
    return fill ? result : demi_mesh_allocate(&t, mesh, 3, vertices, triangles);
}

/* STL as text: facet, three vertex lines, endfacet. Without `fill` it counts and allocates. */
static dem_result demi_stl_pass(demi_text t, dem_mesh *mesh, int fill) {
    size_t facets = 0, axis;
    int corners = 3, ended = 0; /* of this facet, so far; whether `endsolid` came */
    while (demi_text_line(&t)) {
        int vertex = demi_text_is(&t, "vertex"), facet = demi_text_is(&t, "facet");
        int endfacet = demi_text_is(&t, "endfacet"), endsolid = demi_text_is(&t, "endsolid");
        if (facet) facets++;
        if (!fill) continue;
        if (vertex ? corners == 3 : (facet || endfacet || endsolid) && corners < 3)
            return demi_text_fail(&t, "a facet should have three vertices; export the mesh as "
                                  "triangles");
        if (!vertex && !facet && !endfacet && !endsolid && !demi_text_is(&t, "outer") &&
            !demi_text_is(&t, "endloop") && !demi_text_is(&t, "solid"))
            return demi_text_fail(&t, "solid, facet, outer, vertex, endloop, endfacet or endsolid "
                                  "is expected; export the file again");
        if (facet) corners = 0;
        ended = endsolid;
        for (axis = 0; vertex && axis < 3; axis++) {
            size_t corner = 3*(facets - 1) + (size_t)corners;
            demi_text_word(&t);
            if (demi_text_real(&t, &mesh->vertices[3*corner + axis]) != DEM_OK)
                return DEM_ERROR_FORMAT;
        }
        corners += vertex;
    }
    if (!fill) return demi_mesh_allocate(&t, mesh, 3, 3*facets, facets);
    if (ended) return DEM_OK;
    return demi_text_fail(&t, "endsolid is expected; the file is cut short, so copy or export it "
                          "again");
}

static uint32_t demi_little32(const char *data) {
    const unsigned char *b = (const unsigned char *)data;
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

/* Binary STL: 80 bytes, the number of triangles, then 50 bytes for each: a normal, three corners,
   two bytes; all little-endian, in single precision. */
static int demi_stl_binary_is(demi_text t) {
    const size_t size = (size_t)(t.end - t.data);
    return size >= 84 && size == 84 + 50*(uint64_t)demi_little32(t.data + 80);
}
static dem_result demi_stl_binary_pass(demi_text t, dem_mesh *mesh, int fill) {
    const char *data = t.data;
    const size_t count = demi_little32(data + 80);
    size_t i, k;
    if (!fill) return demi_mesh_allocate(&t, mesh, 3, 3*count, count);
    for (i = 0; i < count; i++)
        for (k = 0; k < 9; k++) {
            size_t byte = 84 + 50*i + 12 + 4*k;
            uint32_t bits = demi_little32(data + byte);
            float value;
            memcpy(&value, &bits, sizeof value);
            if ((bits >> 23 & 255) == 255 || fabs((double)value) > DEMI_FARTHEST) /* nan, inf */
                return demi_fail(t.world, DEM_ERROR_FORMAT, "%s: %s byte %.0f: found a coordinate "
                                 "of triangle %.0f that is not a number within +-1e15 (m); export "
                                 "the mesh again", t.call, t.name, (double)byte, (double)i + 1);
            mesh->vertices[9*i + k] = value == 0 ? 0 : (dem_real)value;
        }
    return DEM_OK;
}

/* For every key of `width` bytes the index of the first equal one: count int32, to be
   freed; null without memory. Open addressing, in a table that is at most half full. */
static int32_t *demi_first_equal(dem_world *w, const void *keys, size_t count, size_t width) {
    const char *key = (const char *)keys;
    size_t i, slots = 16;
    int32_t *first, *table; /* table: index + 1, or 0 */
    while (slots < 2*count) slots *= 2;
    first = (int32_t *)demi_alloc(w, count, sizeof(int32_t));
    table = (int32_t *)demi_alloc(w, slots, sizeof(int32_t));
    for (i = 0; first && table && i < count; i++) {
        const char *mine = key + i*width;
        size_t at = (size_t)demi_hash(DEMI_HASH_START, mine, width) & (slots - 1);
        while (table[at] && memcmp(key + (size_t)(table[at] - 1)*width, mine, width) != 0)
            at = (at + 1) & (slots - 1);
        if (!table[at]) table[at] = (int32_t)i + 1;
        first[i] = table[at] - 1;
    }
    demi_free(w, table);
    if (!table) demi_free(w, first);
    return table ? first : 0;
}

/* STL has places where others have corners: merges those that are exactly equal. */
static dem_result demi_mesh_merge(const demi_text *t, dem_mesh *mesh, int *merged) {
    size_t i, count = (size_t)mesh->vertex_count, unique = 0;
    int32_t *first = demi_first_equal(t->world, mesh->vertices, count, 3*sizeof(dem_real));
    dem_real *vertices = 0;
    for (i = 0; first && i < count; i++) unique += first[i] == (int32_t)i;
    if (first) vertices = (dem_real *)demi_alloc(t->world, 3*unique, sizeof(dem_real));
    for (i = 0, unique = 0; vertices && i < count; i++) { /* count = 3 triangles */
        mesh->triangles[i] = first[i] < (int32_t)i ? mesh->triangles[first[i]] : (int32_t)unique;
        if (first[i] == (int32_t)i)
            memcpy(vertices + 3*unique++, mesh->vertices + 3*i, 3*sizeof(dem_real));
    }
    demi_free(t->world, first);
    if (!vertices) return demi_text_memory(t);
    demi_free(t->world, mesh->vertices);
    mesh->vertices = vertices;
    mesh->vertex_count = (int)unique;
    *merged = (int)(count - unique);
    return DEM_OK;
}

/* Writes a number with a decimal point in every locale; returns buffer (32 bytes). */
static const char *demi_format_real(char *buffer, double value, int digits) {
    char raw[64];
    size_t i, n = 0;
    snprintf(raw, sizeof raw, "%.*g", digits, value);
    for (i = 0; raw[i] && n < 31; i++) {
        if (strchr("0123456789+-einfa", raw[i])) buffer[n++] = raw[i];
        else if (n == 0 || buffer[n - 1] != '.') buffer[n++] = '.';
    }
    buffer[n] = 0;
    return buffer;
}

/* Box, slivers and a hint on units: what each triangle tells by itself. */
static void demi_health_shapes(const dem_mesh *mesh, dem_mesh_health *health) {
    double lo[3] = {0, 0, 0}, hi[3] = {0, 0, 0}, extent = 0;
    char number[32];
    int i, k, axis;
    for (i = 0; i < mesh->triangle_count; i++) {
        double p[3][3], side[3][3], longest = 0, area = 0;
        for (k = 0; k < 3; k++) {
            const ptrdiff_t corner = mesh->triangles[3*(ptrdiff_t)i + k];
            const dem_real *vertex = mesh->vertices + 3*corner;
            for (axis = 0; axis < 3; axis++) {
                double x = p[k][axis] = (double)vertex[axis];
                if (x < lo[axis] || i + k == 0) lo[axis] = x;
                if (x > hi[axis] || i + k == 0) hi[axis] = x;
            }
        }
        for (k = 0; k < 3; k++) {
            double *s = side[k];
            for (axis = 0; axis < 3; axis++) s[axis] = p[(k + 1)%3][axis] - p[k][axis];
            longest = fmax(longest, sqrt(s[0]*s[0] + s[1]*s[1] + s[2]*s[2]));
        }
        for (axis = 0; axis < 3; axis++) {
            int b = (axis + 1)%3, c = (axis + 2)%3;
            double x = side[0][b]*side[1][c] - side[0][c]*side[1][b];
            area += x*x;
        }
        area = sqrt(area); /* of the parallelogram: height times longest side */
        health->slivers += !(area > 0 && area >= 1e-3*longest*longest);
    }
    health->box = dem_box_make((dem_real)lo[0], (dem_real)lo[1], (dem_real)lo[2], (dem_real)hi[0],
                               (dem_real)hi[1], (dem_real)hi[2]);
    for (axis = 0; axis < 3; axis++) extent = fmax(extent, hi[axis] - lo[axis]);
    if (extent > 50 || extent < 1e-3)
        snprintf(health->hint, sizeof health->hint, "largest extent is %s m: the file may %s; "
                 "multiply its vertices by %s", demi_format_real(number, extent, 4), extent > 50 ?
                 "be in millimetres" : "have been scaled to metres twice", extent > 50 ?
                 "0.001" : "1000");
}

/* Open and crowded edges, duplicates: what triangles tell together. Pass 0 looks up triangles, pass
   1 edges; a triangle with one corner twice is a sliver and has no edges worth counting. */
static dem_result demi_health_edges(const demi_text *t, const dem_mesh *mesh,
                                    dem_mesh_health *health) {
    size_t i, j, k, n, count = (size_t)mesh->triangle_count, pass;
    int32_t *keys = (int32_t *)demi_alloc(t->world, 6*count, sizeof(int32_t)), *first = 0;
    dem_result result = keys ? DEM_OK : DEM_ERROR_MEMORY;
    for (pass = 0; pass < 2 && result == DEM_OK; pass++) {
        size_t width = 3 - pass;
        for (i = n = 0; i < count; i++) {
            const int32_t *corner = mesh->triangles + 3*i;
            if (pass && (corner[0] == corner[1] || corner[1] == corner[2] ||
                         corner[2] == corner[0])) continue;
            for (k = 0; k < (pass ? 3u : 1u); k++, n++)
                for (j = 0; j < width; j++) { /* in rising order: insert one by one */
                    int32_t *key = keys + n*width, present = corner[(k + j)%3];
                    size_t at = j;
                    for (; at > 0 && key[at - 1] > present; at--) key[at] = key[at - 1];
                    key[at] = present;
                }
        }
        if (n == 0) break;
        first = demi_first_equal(t->world, keys, n, width*sizeof(int32_t));
        if (!first) result = DEM_ERROR_MEMORY;
        if (pass) memset(keys, 0, n*sizeof(int32_t)); /* from here on: triangles at each edge */
        for (i = 0; first && i < n; i++) {
            if (pass) keys[first[i]]++;
            else health->duplicates += first[i] != (int32_t)i;
        }
        for (i = 0; first && pass && i < n; i++) {
            health->open_edges += keys[i] == 1;
            health->crowded_edges += keys[i] > 2;
        }
        demi_free(t->world, first);
    }
    demi_free(t->world, keys);
    return result == DEM_OK ? result : demi_text_memory(t);
}

/* Formats of meshes, a row each (>>add-format), in the order in which they are looked for: binary
   STL comes first, as it too may begin with `solid`. A row: do contents look like it (it moves a
   copy of the text); one of two passes, the first counts and allocates, the second fills; whether
   corners come by place instead of by number, so that equal ones are made one; whether it may hold
   bytes that are not text. What nothing looks like is two counts and lists, as profiles are. */
typedef struct demi_mesh_format {
    int (*is)(demi_text t);
    dem_result (*pass)(demi_text t, dem_mesh *mesh, int fill);
    int by_place, binary;
} demi_mesh_format;
static int demi_stl_is(demi_text t) {
    demi_text_line(&t);
    return demi_text_is(&t, "solid") || demi_text_is(&t, "facet");
}
static int demi_obj_is(demi_text t) {
    static const char *const words[] = {"v", "vn", "vt", "f", "o", "g", "s", "mtllib", "usemtl"};
    size_t i;
    int is = 0;
    demi_text_line(&t);
    for (i = 0; i < sizeof words/sizeof *words; i++) is |= demi_text_is(&t, words[i]);
    return is;
}
static const demi_mesh_format demi_mesh_formats[] = {
    {demi_stl_binary_is, demi_stl_binary_pass, 1, 1},
    {demi_stl_is, demi_stl_pass, 1, 0},
    {demi_obj_is, demi_obj_pass, 0, 0},
};
static const demi_mesh_format *demi_mesh_format_of(demi_text t) {  /* null: lists */
    size_t i;
    for (i = 0; i < sizeof demi_mesh_formats/sizeof *demi_mesh_formats; i++)
        if (demi_mesh_formats[i].is(t)) return &demi_mesh_formats[i];
    return 0;
}

/* Any bytes -> a mesh (width 3) or the segments of a profile (2), or a sentence and an empty mesh.
   Contents tell formats apart. */
static dem_result demi_parse(dem_world *w, const char *call, const char *name, const char *data,
                             size_t size, size_t width, dem_mesh *mesh, dem_mesh_health *health) {
    demi_text t = demi_text_make(w, call, name, data, size);
    const demi_mesh_format *format = width == 3 ? demi_mesh_format_of(t) : 0;
    dem_result result;
    int merged = 0;
    if (!(format && format->binary) && memchr(data, 0, size)) {
        result = demi_fail(w, DEM_ERROR_FORMAT, "%s: %s: found %.0f bytes that are not text%s; the "
                           "file is cut short or of another format, so copy or export it again",
                           call, t.name, (double)size, width == 2 ? "" : ", where a binary STL has "
                           "84 and 50 for each triangle it counts");
    } else if (format) {
        result = format->pass(t, mesh, 0);
        if (result == DEM_OK) result = format->pass(t, mesh, 1);
        if (result == DEM_OK && format->by_place) result = demi_mesh_merge(&t, mesh, &merged);
    } else {
        result = demi_lists_read(&t, width, mesh);
    }
    if (result == DEM_OK && health) {
        health->merged_vertices = merged;
        demi_health_shapes(mesh, health);
        result = demi_health_edges(&t, mesh, health);
    }
    if (result != DEM_OK) {
        demi_mesh_free(w, mesh);
        if (health) memset(health, 0, sizeof *health);
    }
    return result;
}

/* Loads a file whole into bytes, which the caller frees, also after a failure. */
static dem_result demi_load(dem_world *w, const char *call, const char *path, char **bytes,
                            size_t *size) {
    FILE *file;
    dem_result result = DEM_OK;
    *size = 0;
    if (!path)
        return demi_fail(w, DEM_ERROR_ARGUMENT, "%s: path is null; give a file name", call);
    errno = 0;
    file = fopen(path, "rb");
    while (file && !feof(file) && !ferror(file) && result == DEM_OK) {
        if (demi_grow(w, DEMI_LOOSE, bytes, 1, *size + 65536))
            *size += fread(*bytes + *size, 1, demi_room(*bytes, 1) - *size, file);
        else result = demi_fail(w, DEM_ERROR_MEMORY, "%s: %.200s: no memory to load it beyond %.0f "
                                "bytes; free some", call, path, (double)*size);
    }
    if (result == DEM_OK && (!file || ferror(file)))
        result = demi_fail(w, DEM_ERROR_FILE, "%s: cannot read %.200s: %s; check its name and "
                           "permissions", call, path, errno ? strerror(errno) : "unknown cause");
    if (file) fclose(file);
    return result;
}

/* demi_parse for a file. */
static dem_result demi_read(dem_world *w, const char *call, const char *path, size_t width,
                            dem_mesh *mesh, dem_mesh_health *health) {
    char *bytes = 0;
    size_t size;
    dem_result result = demi_load(w, call, path, &bytes, &size);
    if (result == DEM_OK) result = demi_parse(w, call, path, bytes, size, width,
                                              mesh, health);
    demi_free(w, bytes);
    return result;
}

DEM_API dem_result dem_mesh_parse(dem_world *world, const char *name, const void *data, size_t size,
                          dem_mesh *mesh, dem_mesh_health *health) {
    if (demi_null(world, "dem_mesh_parse", world, "world")) return DEM_ERROR_ARGUMENT;
    if (mesh) memset(mesh, 0, sizeof *mesh);
    if (health) memset(health, 0, sizeof *health);
    if (!mesh || !data)
        return demi_fail(world, DEM_ERROR_ARGUMENT, "dem_mesh_parse: %s is null; give its address",
                         mesh ? "data" : "mesh");
    return demi_parse(world, "dem_mesh_parse", name, (const char *)data, size, 3, mesh, health);
}

DEM_API dem_result dem_mesh_read(dem_world *world, const char *path, dem_mesh *mesh,
                                 dem_mesh_health *health) {
    if (demi_null(world, "dem_mesh_read", world, "world")) return DEM_ERROR_ARGUMENT;
    if (health) memset(health, 0, sizeof *health);
    if (!mesh)
        return demi_fail(world, DEM_ERROR_ARGUMENT, "dem_mesh_read: mesh is null; give its "
                         "address");
    memset(mesh, 0, sizeof *mesh);
    return demi_read(world, "dem_mesh_read", path, 3, mesh, health);
}

DEM_API void dem_mesh_free(dem_world *world, dem_mesh *mesh) {
    if (world && mesh) demi_mesh_free(world, mesh);
}

/* What was read as a mesh of width 2, as a profile. */
static dem_result demi_profile_take(dem_world *w, const char *call, const char *name,
                                    const dem_mesh *lists, dem_profile *profile) {
    int i;
    profile->vertex_count = lists->vertex_count;
    profile->segment_count = lists->triangle_count;
    profile->vertices = lists->vertices;
    profile->segments = lists->triangles;
    for (i = 0; i < profile->segment_count; i++) {
        const int32_t *segment = profile->segments + 2*(size_t)i;
        if (segment[0] != segment[1]) continue;
        dem_profile_free(w, profile);
        return demi_fail(w, DEM_ERROR_FORMAT, "%s: %.200s: found segment %d with one corner twice "
                         "where two are expected; correct it or take it out", call,
                         name ? name : "data", i + 1);
    }
    return DEM_OK;
}

DEM_API dem_result dem_profile_parse(dem_world *world, const char *name, const void *data,
                                     size_t size, dem_profile *profile) {
    if (demi_null(world, "dem_profile_parse", world, "world")) return DEM_ERROR_ARGUMENT;
    dem_mesh lists = {0, 0, 0, 0};
    dem_result result;
    if (profile) memset(profile, 0, sizeof *profile);
    if (!profile || !data)
        return demi_fail(world, DEM_ERROR_ARGUMENT, "dem_profile_parse: %s is null; give its "
                         "address", profile ? "data" : "profile");
    result = demi_parse(world, "dem_profile_parse", name, (const char *)data, size, 2, &lists, 0);
    if (result != DEM_OK) return result;
    return demi_profile_take(world, "dem_profile_parse", name, &lists, profile);
}

DEM_API dem_result dem_profile_read(dem_world *world, const char *path, dem_profile *profile) {
    if (demi_null(world, "dem_profile_read", world, "world")) return DEM_ERROR_ARGUMENT;
    dem_mesh lists = {0, 0, 0, 0};
    dem_result result;
    if (!profile)
        return demi_fail(world, DEM_ERROR_ARGUMENT, "dem_profile_read: profile is null; give its "
                         "address");
    memset(profile, 0, sizeof *profile);
    result = demi_read(world, "dem_profile_read", path, 2, &lists, 0);
    if (result != DEM_OK) return result;
    return demi_profile_take(world, "dem_profile_read", path, &lists, profile);
}

DEM_API void dem_profile_free(dem_world *world, dem_profile *profile) {
    if (!world || !profile) return;
    demi_free(world, profile->vertices);
    demi_free(world, profile->segments);
    memset(profile, 0, sizeof *profile);
}

/* ---------------------------------------------------------------------------------------------
   >>write
   demi_out_open gives a file of the name path.tmp; demi_out_close renames it to path when all went
   well and removes it otherwise, so what stands under path is whole. A symbolic link stays: the
   file it leads to is the one replaced. Pipes and terminals are refused, and what is there but
   empty (a file, a device such as /dev/null) is written to as it is: it has nothing to lose. Write
   errors stick to the FILE and are looked at once, on closing. Text has decimal points whatever the
   locale says.
   --------------------------------------------------------------------------------------------- */

typedef struct demi_out {
    dem_world *world;
    const char *call, *path;
    char *place;                /* path, or where it leads when it is a link                      */
    char *temporary;            /* place.tmp; null: place itself is written to                    */
    size_t room;                /* bytes of each of the two                                       */
    FILE *file;
} demi_out;

/* Where a symbolic link leads; 0: path is none. C has no word for links: on Unix we ask readlink by
   its name in the C library, without the header, whose names would then stand in every program.
   Elsewhere a link is replaced by a file. */
#if (defined(__unix__) || defined(__linux__)) && (defined(__GNUC__) || defined(__TINYC__)) && \
    !defined(__CYGWIN__)
long demi_readlink(const char *path, char *to, size_t size) __asm__("readlink");
#elif defined(__APPLE__) && defined(__GNUC__)
long demi_readlink(const char *path, char *to, size_t size) __asm__("_readlink");
#else
static long demi_readlink(const char *path, char *to, size_t size) {
    (void)path; (void)to; (void)size;
    return -1;
}
#endif
enum { DEMI_LINK = 1024, DEMI_LINKS = 16 };   /* bytes of a link's target; links on the way */
/* Replaces place by what it leads to when it is a link. 0: too long, or in a circle. */
static int demi_link_follow(char *place, size_t room) {
    char to[DEMI_LINK];
    int i;
    for (i = 0; i < DEMI_LINKS; i++) {
        const long n = demi_readlink(place, to, sizeof to);
        const char *slash = strrchr(place, '/');
        const size_t folder = n < 1 || to[0] == '/' || !slash ? 0 : (size_t)(slash - place) + 1;
        if (n < 0) return 1;
        if ((size_t)n >= sizeof to || folder + (size_t)n + 5 > room) return 0;
        memcpy(place + folder, to, (size_t)n);
        place[folder + (size_t)n] = 0;
    }
    return 0;
}

static void demi_out_free(demi_out *o) {
    demi_free(o->world, o->place);
    demi_free(o->world, o->temporary);
}
/* Ends a file: renames it to its place if all was written, removes it if not. Where rename refuses
   to replace a file (Windows), the old one is removed first; a folder of that name never is. */
static dem_result demi_out_close(demi_out *o) {
    int whole = o->file && fflush(o->file) == 0 && !ferror(o->file), cause = errno;
    if (o->file && fclose(o->file) != 0 && whole) {
        whole = 0;
        cause = errno;
    }
    if (whole && o->temporary && rename(o->temporary, o->place) != 0) {
        cause = errno;
        whole = (cause == EEXIST || cause == EACCES) && remove(o->place) == 0 &&
                rename(o->temporary, o->place) == 0;
    }
    if (!whole) {
        if (o->file && o->temporary) remove(o->temporary);
        if (o->file && !o->temporary) {         /* it was empty: so it is again */
            FILE *empty = fopen(o->place, "wb");
            if (empty) fclose(empty);
        }
        demi_fail(o->world, DEM_ERROR_FILE, "%s: cannot write %.200s: %s; check that its folder "
                  "exists, may be written to and has room", o->call, o->path,
                  cause ? strerror(cause) : "unknown cause");
    }
    demi_out_free(o);
    return whole ? DEM_OK : DEM_ERROR_FILE;
}

/* Begins a file under a temporary name. If this fails there is nothing to close. */
static dem_result demi_out_open(demi_out *o, dem_world *w, const char *call, const char *path) {
    size_t length;
    FILE *there;
    if (!path) return demi_fail(w, DEM_ERROR_ARGUMENT, "%s: path is null; give a file name", call);
    memset(o, 0, sizeof *o);
    o->world = w;
    o->call = call;
    o->path = path;
    length = strlen(path);
    o->room = length + DEMI_LINK + 5;
    o->place = (char *)demi_alloc(w, o->room, 1);
    o->temporary = (char *)demi_alloc(w, o->room, 1);
    if (!o->place || !o->temporary) {
        demi_out_free(o);
        return demi_fail(w, DEM_ERROR_MEMORY, "%s: no memory for a file name; free some", call);
    }
    memcpy(o->place, path, length + 1);
    there = fopen(path, "r+b");                 /* of a pipe: does not wait for its other end */
    if (there && fseek(there, 0, SEEK_END) != 0) {
        fclose(there);
        demi_out_free(o);
        return demi_fail(w, DEM_ERROR_FILE, "%s: %.200s is a pipe or a terminal, must be a file, "
                         "which is written whole or not at all; write a file and send that", call,
                         path);
    }
    errno = 0;
    if (there && ftell(there) == 0) {
        demi_free(w, o->temporary);
        o->temporary = 0;
        o->file = there;
        return DEM_OK;
    }
    if (there) fclose(there);
    if (!demi_link_follow(o->place, o->room)) {
        demi_out_free(o);
        return demi_fail(w, DEM_ERROR_FILE, "%s: %.200s is a link that leads in a circle or "
                         "through too many others; give the file itself", call, path);
    }
    length = strlen(o->place);
    memcpy(o->temporary, o->place, length);
    memcpy(o->temporary + length, ".tmp", 5);
    errno = 0;
    o->file = fopen(o->temporary, "wb");
    return o->file ? DEM_OK : demi_out_close(o);
}

/* Of this machine: formats say which order they want. */
static int demi_is_little_endian(void) {
    const uint16_t one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    return first == 1;
}

/* One binary number of at most 8 bytes, turned round if asked. */
static void demi_out_number(demi_out *o, const void *number, size_t size, int turn) {
    unsigned char bytes[8];
    size_t i;
    for (i = 0; i < size; i++) bytes[i] = ((const unsigned char *)number)[turn ? size - 1 - i : i];
    fwrite(bytes, 1, size, o->file);
}

/* An array in a picture: count rows of `components` numbers. Without data it is the row of numbers
   first, first + stride, ... */
typedef struct demi_column {
    const char *section, *name; /* section: of a VTP file                                         */
    char type;                  /* r dem_real, i int32, u uint32                                  */
    int components, count;      /* numbers in a row, rows                                        */
    int stride, first;          /* numbers from row to row; to the first                         */
    const void *data;
} demi_column;

static size_t demi_column_size(const demi_column *c) { /* bytes of one number */
    return c->type == 'r' ? sizeof(dem_real) : 4;
}

static uint64_t demi_column_bytes(const demi_column *c) {
    return (uint64_t)c->count*(uint64_t)c->components*demi_column_size(c);
}

/* A column without data counts: first, first + stride, and so on. */
static void demi_column_write(demi_out *o, const demi_column *c, int turn) {
    const char *data = (const char *)c->data;
    size_t size = demi_column_size(c);
    int i, k;
    for (i = 0; i < c->count; i++) {
        if (!data) {
            const int32_t number = c->first + i*c->stride;
            demi_out_number(o, &number, sizeof number, turn);
            continue;
        }
        for (k = 0; k < c->components; k++) {
            size_t at = (size_t)i*(size_t)c->stride + (size_t)(c->first + k);
            demi_out_number(o, data + at*size, size, turn);
        }
    }
}

enum { DEMI_GRAIN_COLUMNS = 10 };

/* What is drawn of the bodies: the arrays as they are or, where there are clusters and ellipsoids,
   one row for each part, in arrays of its own. */
typedef struct demi_drawing {
    int count;
    const dem_real *pos, *vel, *spin;              /* count x 4 */
    const dem_real *orient, *axes;                 /* count x 4; null: no orientations */
    const uint32_t *slots;
    const int32_t *materials;
    dem_real *own;                                 /* count x 20 */
    int32_t *own_ids;                              /* count x 2 */
} demi_drawing;
/* 0 when memory ran out. */
static int demi_drawing_make(dem_world *w, demi_drawing *g) {
    const dem_real *places = demi_wrapped(w);
    dem_real *row;
    int i, k, e, n = 0;
    memset(g, 0, sizeof *g);
    g->count = w->bodies.count;
    g->pos = places; g->vel = w->bodies.vel; g->spin = w->bodies.spin;
    g->slots = w->bodies.slot; g->materials = w->bodies.material;
    if (!w->bodies.orienting) return 1;
    g->count = 0;
    for (i = 0; i < w->bodies.count; i++) g->count += demi_parts_count(w, i);
    g->own = (dem_real *)demi_alloc(w, 20*(size_t)g->count + 1, sizeof(dem_real));
    g->own_ids = (int32_t *)demi_alloc(w, 2*(size_t)g->count + 1, sizeof(int32_t));
    if (!g->own || !g->own_ids) return 0;
    for (i = 0; i < w->bodies.count; i++)
        for (k = 0; k < demi_parts_count(w, i); k++, n++) {
            const demi_part p = demi_part_of(w, i, k);
            row = g->own + 4*n;
            demi_put(row, demi_add(demi_at(places + 4*i), p.centre));
            row[3] = p.radius;
            row += 4*(size_t)g->count;
            demi_put(row, demi_velocity_at(w->bodies.vel, w->bodies.spin, i, p.centre));
            row += 4*(size_t)g->count;
            demi_put(row, demi_at(w->bodies.spin + 4*i));
            row += 4*(size_t)g->count;
            for (e = 0; e < 4; e++) row[e] = w->bodies.orient[4*i + e];
            row += 4*(size_t)g->count;
            demi_put(row, demi_shape_rows[p.kind].drawn(&p));
            g->own_ids[n] = (int32_t)w->bodies.slot[i];
            g->own_ids[n + g->count] = w->bodies.material[i];
        }
    g->pos = g->own;
    g->vel = g->own + 4*(size_t)g->count;
    g->spin = g->own + 8*(size_t)g->count;
    g->orient = g->own + 12*(size_t)g->count;
    g->axes = g->own + 16*(size_t)g->count;
    g->slots = (const uint32_t *)g->own_ids;
    g->materials = g->own_ids + g->count;
    return 1;
}
static void demi_drawing_free(dem_world *w, demi_drawing *g) {
    if (!w->bodies.orienting) return;
    demi_free(w, g->own);
    demi_free(w, g->own_ids);
}
static dem_result demi_drawing_fails(dem_world *w, const char *call, demi_drawing *g) {
    demi_drawing_free(w, g);
    return demi_fail(w, DEM_ERROR_MEMORY, "%s: no memory for the %d parts of the bodies; free some",
                     call, g->count);
}

/* What is told of grains; the last two make a cell of every point, so that it is drawn. */
/* Answers how many columns there are; the last two hold no data. */
static int demi_grain_columns(const demi_drawing *g, demi_column *columns) {
    const demi_column all[DEMI_GRAIN_COLUMNS] = {
        {"Points",    "position",     'r', 3, g->count, 4, 0, g->pos},
        {"PointData", "radius",       'r', 1, g->count, 4, 3, g->pos},
        {"PointData", "velocity",     'r', 3, g->count, 4, 0, g->vel},
        {"PointData", "spin",         'r', 3, g->count, 4, 0, g->spin},
        {"PointData", "id",           'u', 1, g->count, 1, 0, g->slots},
        {"PointData", "material",     'i', 1, g->count, 1, 0, g->materials},
        {"PointData", "orientation",  'r', 4, g->count, 4, 0, g->orient},
        {"PointData", "semi_axes",    'r', 3, g->count, 4, 0, g->axes},
        {"Verts",     "connectivity", 'i', 1, g->count, 1, 0, 0},
        {"Verts",     "offsets",      'i', 1, g->count, 1, 1, 0}};
    const int skip = g->orient ? 0 : 2;
    memcpy(columns, all, 6*sizeof *all);
    memcpy(columns + 6, all + 6 + skip, (size_t)(4 - skip)*sizeof *all);
    return DEMI_GRAIN_COLUMNS - skip;
}

/* VTK's XML format: the tree tells what there is; the numbers follow as they lie in memory, each
   array after its size in bytes. The first column holds the points. */
static dem_result demi_vtp(dem_world *w, const char *call, const char *path,
                           const demi_column *column, int columns, int verts, int polys) {
    demi_out o;
    char time[32];
    const char *section = "";
    uint64_t offset = 0, bytes;
    int i;
    dem_result result = demi_out_open(&o, w, call, path);
    if (result != DEM_OK) return result;
    fprintf(o.file, "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
            "byte_order=\"%s\" header_type=\"UInt64\">\n<PolyData>\n<FieldData><DataArray "
            "type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">%s"
            "</DataArray></FieldData>\n<Piece NumberOfPoints=\"%d\" NumberOfVerts=\"%d\" "
            "NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"%d\">\n",
            demi_is_little_endian() ? "LittleEndian" : "BigEndian",
            demi_format_real(time, dem_world_time(w), 17), column[0].count, verts, polys);
    for (i = 0; i < columns; i++) {
        const demi_column *c = column + i;
        if (i > 0 && strcmp(c->section, section) != 0) fprintf(o.file, "</%s>\n", section);
        if (strcmp(c->section, section) != 0) fprintf(o.file, "<%s>\n", c->section);
        section = c->section;
        fprintf(o.file, "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" "
                "format=\"appended\" offset=\"%.0f\"/>\n", c->type == 'u' ? "UInt32" :
                c->type == 'i' ? "Int32" : sizeof(dem_real) == 4 ? "Float32" : "Float64", c->name,
                c->components, (double)offset);
        offset += 8 + demi_column_bytes(c);
    }
    fprintf(o.file, "</%s>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_", section);
    for (i = 0; i < columns; i++) {
        bytes = demi_column_bytes(column + i);
        demi_out_number(&o, &bytes, sizeof bytes, 0);
        demi_column_write(&o, column + i, 0);
    }
    fputs("\n</AppendedData>\n</VTKFile>\n", o.file);
    return demi_out_close(&o);
}

DEM_API dem_result dem_vtp_write(dem_world *world, const char *path) {
    if (demi_null(world, "dem_vtp_write", world, "world")) return DEM_ERROR_ARGUMENT;
    demi_column column[DEMI_GRAIN_COLUMNS];
    demi_drawing g;
    dem_result result;
    int n;
    if (!demi_drawing_make(world, &g)) return demi_drawing_fails(world, "dem_vtp_write", &g);
    n = demi_grain_columns(&g, column);
    result = demi_vtp(world, "dem_vtp_write", path, column, n, column[0].count, 0);
    demi_drawing_free(world, &g);
    return result;
}

/* Legacy VTK, in its binary form: numbers are big-endian. */
DEM_API dem_result dem_vtk_write(dem_world *world, const char *path) {
    if (demi_null(world, "dem_vtk_write", world, "world")) return DEM_ERROR_ARGUMENT;
    demi_column column[DEMI_GRAIN_COLUMNS];
    demi_out o;
    const char *real = sizeof(dem_real) == 4 ? "float" : "double";
    double time = dem_world_time(world);
    int i, n, count, turn = demi_is_little_endian();
    demi_drawing g;
    dem_result result;
    if (!demi_drawing_make(world, &g)) return demi_drawing_fails(world, "dem_vtk_write", &g);
    result = demi_out_open(&o, world, "dem_vtk_write", path);
    if (result != DEM_OK) { demi_drawing_free(world, &g); return result; }
    n = demi_grain_columns(&g, column);
    count = column[0].count;
    fputs("# vtk DataFile Version 3.0\ndem.h\nBINARY\nDATASET POLYDATA\nFIELD FieldData 1\n"
          "TIME 1 1 double\n", o.file);
    demi_out_number(&o, &time, sizeof time, turn);
    fprintf(o.file, "\nPOINTS %d %s\n", count, real);
    demi_column_write(&o, column, turn);
    fprintf(o.file, "\nVERTICES %d %.0f\n", count, 2*(double)count);
    for (i = 0; i < count; i++) { /* a cell: the number of its points, then their indices */
        int32_t cell[2];
        cell[0] = 1;
        cell[1] = i;
        demi_out_number(&o, cell, 4, turn);
        demi_out_number(&o, cell + 1, 4, turn);
    }
    fprintf(o.file, "\nPOINT_DATA %d\n", count);
    for (i = 1; i < n - 2; i++) {
        const demi_column *c = column + i;
        const char *type = c->type == 'u' ? "unsigned_int" : c->type == 'i' ? "int" : real;
        if (c->components == 4)
            fprintf(o.file, "SCALARS %s %s 4\nLOOKUP_TABLE default\n", c->name, type);
        else if (c->components == 3) fprintf(o.file, "VECTORS %s %s\n", c->name, type);
        else fprintf(o.file, "SCALARS %s %s 1\nLOOKUP_TABLE default\n", c->name, type);
        demi_column_write(&o, c, turn);
        fputs("\n", o.file);
    }
    demi_drawing_free(world, &g);
    return demi_out_close(&o);
}

/* Extended XYZ. Species, which ASE wants to be chemical elements, tell the material: H is 1, He 2,
   and so on. A domain becomes the lattice; an axis without extent gets 1 m. */
DEM_API dem_result dem_xyz_write(dem_world *world, const char *path) {
    if (demi_null(world, "dem_xyz_write", world, "world")) return DEM_ERROR_ARGUMENT;
    static const char elements[] =
        "H HeLiBeB C N O F NeNaMgAlSiP S ClArK CaScTiV CrMnFeCoNiCuZnGaGe"
        "AsSeBrKrRbSrY ZrNbMoTcRuRhPdAgCdInSnSbTeI XeCsBaLaCePrNdPmSmEuGd";
    demi_drawing g;
    dem_world_desc desc = dem_world_desc_get(world);
    dem_box d = desc.domain;
    double length[3];
    char text[3][32];
    demi_out o;
    int i, k;
    dem_result result;
    if (!demi_drawing_make(world, &g)) return demi_drawing_fails(world, "dem_xyz_write", &g);
    result = demi_out_open(&o, world, "dem_xyz_write", path);
    if (result != DEM_OK) { demi_drawing_free(world, &g); return result; }
    length[0] = (double)(d.hi.x - d.lo.x);
    length[1] = (double)(d.hi.y - d.lo.y);
    length[2] = (double)(d.hi.z - d.lo.z);
    fprintf(o.file, "%d\n", g.count);
    if (length[0] > 0 || length[1] > 0 || length[2] > 0) {
        for (k = 0; k < 3; k++) demi_format_real(text[k], length[k] > 0 ? length[k] : 1, 9);
        fprintf(o.file, "Lattice=\"%s 0 0 0 %s 0 0 0 %s\" ", text[0], text[1], text[2]);
        demi_format_real(text[0], (double)d.lo.x, 9);
        demi_format_real(text[1], (double)d.lo.y, 9);
        demi_format_real(text[2], (double)d.lo.z, 9);
        fprintf(o.file, "Origin=\"%s %s %s\" pbc=\"", text[0], text[1], text[2]);
        for (k = 0; k < 3; k++)
            fprintf(o.file, desc.boundary[k] == DEM_BOUNDARY_PERIODIC ? "T%s" : "F%s",
                    k < 2 ? " " : "\" ");
    }
    fprintf(o.file, "Properties=species:S:1:pos:R:3:radius:R:1:velo:R:3:%sid:I:1 Time=%s\n",
            g.orient ? "orientation:R:4:aspherical_shape:R:3:" : "",
            demi_format_real(text[0], dem_world_time(world), 12));
    for (i = 0; i < g.count; i++) {
        const char *element = elements + 2*((g.materials[i] - 1) & 63);
        fprintf(o.file, "%.*s", element[1] == ' ' ? 1 : 2, element);
        for (k = 0; k < 7; k++) {
            const dem_real *row = (k < 4 ? g.pos : g.vel) + 4*(size_t)i;
            fprintf(o.file, " %s", demi_format_real(text[0], (double)row[k < 4 ? k : k - 4], 9));
        }
        for (k = 0; k < 7 && g.orient; k++) {   /* x y z w, then the axes */
            const dem_real *row = (k < 4 ? g.orient : g.axes) + 4*(size_t)i;
            fprintf(o.file, " %s", demi_format_real(text[0],
                    (double)row[k < 4 ? (k + 1)%4 : k - 4], 9));
        }
        fprintf(o.file, " %lu\n", (unsigned long)g.slots[i]);
    }
    demi_drawing_free(world, &g);
    return demi_out_close(&o);
}

/* ---- walls and loads out ---- */

/* Adds wall i as it lies now: its points (those of a profile at z[0], then at z[1]) and triangles
   (a segment a b, with A B above it, becomes a b B and a B A). Without arrays it only counts. */
static void demi_wall_draw(const dem_world *w, int i, const dem_real *z, int64_t *points,
                           int64_t *triangles, dem_real *place, int32_t *corners, int32_t *id) {
    const demi_wall *wall = w->walls + i;
    int64_t k, up = wall->vertex_count, base = *points;
    int c, profile = demi_wall_is(wall, DEMI_DRAWN), sides = profile ? 2 : 1;
    dem_pose pose;
    dem_wall handle;
    handle.id = i + 1;
    if (demi_wall_per(wall) < 2) return;
    *points += sides*up;
    *triangles += sides*(int64_t)wall->element_count;
    if (!place || dem_wall_pose(w, handle, &pose) != DEM_OK) return;
    for (k = 0; k < sides*up; k++) {
        dem_vec3 local = demi_at(wall->vertices + 3*(k%up));
        if (profile) local.z = z[k/up];
        demi_put(place + 3*(base + k), demi_add(pose.position, demi_rotate(pose.rotation, local)));
    }
    for (k = 0; k < sides*(int64_t)wall->element_count; k++) {
        int64_t at = *triangles - sides*(int64_t)wall->element_count + k;
        const int32_t *from = wall->corners + (profile ? k/2*2 : 3*k);
        int64_t to[3];
        to[0] = from[0];
        to[1] = profile && k%2 ? from[1] + up : from[1];
        to[2] = !profile ? from[2] : (k%2 ? from[0] : from[1]) + up;
        for (c = 0; c < 3; c++) corners[3*at + c] = (int32_t)(base + to[c]);
        id[at] = i + 1;
    }
}

DEM_API dem_result dem_walls_vtp_write(dem_world *world, const char *path, dem_real z0,
                                       dem_real z1) {
    if (demi_null(world, "dem_walls_vtp_write", world, "world")) return DEM_ERROR_ARGUMENT;
    int64_t points = 0, triangles = 0, p = 0, t = 0;
    dem_real z[2], *place = 0;
    int32_t *corners = 0, *id = 0;
    size_t room[2];
    int i, profiles = 0;
    dem_result result;
    z[0] = z0;
    z[1] = z1;
    for (i = 0; i < world->wall_count; i++) {
        demi_wall_draw(world, i, z, &points, &triangles, 0, 0, 0);
        profiles += demi_wall_is(&world->walls[i], DEMI_DRAWN);
    }
    if (profiles && !(z1 > z0))
        return demi_fail(world, DEM_ERROR_ARGUMENT, "dem_walls_vtp_write: z0 is %g and z1 is %g, "
                         "but must be z0 < z1 to draw out a profile; change them", (double)z0,
                         (double)z1);
    room[0] = 3*(size_t)points + 1; /* never nothing */
    room[1] = (size_t)triangles + 1;
    if (points < DEMI_ELEMENTS_MAX && triangles < DEMI_ELEMENTS_MAX) {
        place = (dem_real *)demi_alloc(world, room[0], sizeof(dem_real));
        corners = (int32_t *)demi_alloc(world, 3*room[1], sizeof(int32_t));
        id = (int32_t *)demi_alloc(world, room[1], sizeof(int32_t));
    }
    if (place && corners && id) {
        for (i = 0; i < world->wall_count; i++)
            demi_wall_draw(world, i, z, &p, &t, place, corners, id);
        const demi_column column[] = {
            {"Points",   "position",     'r', 3, (int)points,      3, 0, place},
            {"CellData", "wall",         'i', 1, (int)triangles,   1, 0, id},
            {"Polys",    "connectivity", 'i', 1, (int)triangles*3, 1, 0, corners},
            {"Polys",    "offsets",      'i', 1, (int)triangles,   3, 3, 0}};
        result = demi_vtp(world, "dem_walls_vtp_write", path, column, 4, 0, (int)triangles);
    } else {
        result = demi_fail(world, DEM_ERROR_MEMORY, "dem_walls_vtp_write: no memory for %.0f "
                           "points and %.0f triangles; free some", (double)points,
                           (double)triangles);
    }
    demi_free(world, place);
    demi_free(world, corners);
    demi_free(world, id);
    return result;
}

/* Appending cannot go by way of a temporary name. Instead the line goes out in one piece, and after
   one that was cut short (a full disk, a killed run) a new line is begun. */
DEM_API dem_result dem_wall_loads_csv(dem_world *world, dem_wall wall, const char *path) {
    if (demi_null(world, "dem_wall_loads_csv", world, "world")) return DEM_ERROR_ARGUMENT;
    static const char heading[] = "time,fx,fy,fz,tx,ty,tz,torque_axial,power,contacts\n";
    dem_wall_loads c;
    dem_real value[8];
    double time = dem_world_time(world);
    char text[sizeof heading + 10*32], number[32];
    int i, n = 0, last = '\n', whole, cause;
    FILE *file;
    if (!path)
        return demi_fail(world, DEM_ERROR_ARGUMENT, "dem_wall_loads_csv: path is null; give a file "
                         "name");
    if (dem_wall_loads_get(world, wall, &c) != DEM_OK)
        return demi_fail(world, DEM_ERROR_ARGUMENT, "dem_wall_loads_csv: wall %ld names none; give "
                         "one that was added and not removed", (long)wall.id);
    value[0] = c.force.x;
    value[1] = c.force.y;
    value[2] = c.force.z;
    value[3] = c.torque.x;
    value[4] = c.torque.y;
    value[5] = c.torque.z;
    value[6] = c.torque_axial;
    value[7] = c.power;
    errno = 0;
    file = fopen(path, "a+b");
    whole = file && fseek(file, 0, SEEK_END) == 0;
    if (whole && ftell(file) > 0) {
        whole = fseek(file, -1, SEEK_END) == 0;
        last = whole ? fgetc(file) : last;
        whole = whole && fseek(file, 0, SEEK_END) == 0; /* C wants a seek between read and write */
        n = snprintf(text, sizeof text, "%s", last == '\n' ? "" : "\n");
    } else n = snprintf(text, sizeof text, "%s", heading);
    n += snprintf(text + n, sizeof text - (size_t)n, "%s", demi_format_real(number, time, 12));
    for (i = 0; i < 8; i++) {
        demi_format_real(number, (double)value[i], 9);
        n += snprintf(text + n, sizeof text - (size_t)n, ",%s", number);
    }
    n += snprintf(text + n, sizeof text - (size_t)n, ",%d\n", c.contacts);
    whole = whole && fwrite(text, 1, (size_t)n, file) == (size_t)n && fflush(file) == 0;
    cause = errno;
    if (file) fclose(file);
    if (whole) return DEM_OK;
    return demi_fail(world, DEM_ERROR_FILE,
                     "dem_wall_loads_csv: cannot write %.200s: %s; check that "
                     "its folder exists, may be written to and has room", path,
                     cause ? strerror(cause) : "unknown cause");
}

/* ---------------------------------------------------------------------------------------------
   >>checkpoint
   Everything that decides the next step, in one visit that both writes and reads, so that the two
   cannot differ. The file: magic, version, size of dem_real, byte order, counts; a digest of each
   part of the scene (desc, materials, pairs, shapes, walls, fields, feeds, outlets); numbers,
   domains, bodies, lists, contacts; check sum of all before it.

   What hangs on the list of candidates (laws in force, reals of memory per contact, coefficients
   that dem_pair_set has outdated) is stored and not worked out anew: the scene may have changed
   since the list was made. Of a list that no longer fits the bodies only the counts are stored, by
   which the next one is chosen.
   --------------------------------------------------------------------------------------------- */
#define DEMI_CHECKPOINT_MAGIC "DEM-CKPT"
enum { DEMI_CHECKPOINT_VERSION = 10 };

/* Writes to file or to memory, or reads the `left` bytes that are at `from`, or (with none of them)
   counts bytes. */
typedef struct demi_stream {
    FILE *file;
    char *to;
    const char *from;
    uint64_t sum;
    size_t size, left;
    int cut;                         /* more was to be read than there was */
} demi_stream;

static void demi_visit(demi_stream *s, void *data, size_t size) {
    s->size += size;
    if (!size) return;
    if (s->file) {
        s->sum = demi_hash(s->sum, data, size);
        fwrite(data, 1, size, s->file);
    } else if (s->to) {
        memcpy(s->to, data, size);
        s->to += size;
    } else if (s->from && size <= s->left) {
        memcpy(data, s->from, size);
        s->from += size;
        s->left -= size;
    } else if (s->from) {
        memset(data, 0, size);
        s->left = 0;
        s->cut = 1;
    }
}
#define DEMI_VISIT(s, value) demi_visit(s, &(value), sizeof(value))

/* --- the scene: what a file and the world that reads it must have in common --- */

/* --- digests of the parts of a scene: numbers that decide what a run does; pointers only as far as
       whether there is one --- */
static uint64_t demi_digest_desc(const dem_world *w, int index) {
    const dem_world_desc *d = &w->asked;
    const int flags[] = {(int)d->boundary[0], (int)d->boundary[1], (int)d->boundary[2], d->planar,
                         (int)d->normal_law, (int)d->tangent_law, (int)d->rolling_law,
                         (int)d->tension, (int)d->convention, d->law != 0, d->law_memory,
                         d->law_vectors, d->force != 0, (int)d->integrator, (int)d->search,
                         d->ledger, (int)d->rotation, (int)d->ellipsoid_overlap,
                         (int)d->cluster_contacts, d->orientations};
    const dem_real numbers[] = {d->gravity.x, d->gravity.y, d->gravity.z, d->domain.lo.x,
                                d->domain.lo.y, d->domain.lo.z, d->domain.hi.x, d->domain.hi.y,
                                d->domain.hi.z, d->thickness, d->dt, d->impact_speed, d->skin};
    (void)index;
    return demi_hash(demi_hash(DEMI_HASH_START, flags, sizeof flags), numbers, sizeof numbers);
}
static uint64_t demi_digest_material(const dem_world *w, int i) {
    return demi_hash(DEMI_HASH_START, &w->materials[i], sizeof w->materials[i]);
}
/* A row of the table: the material with every other. */
static uint64_t demi_digest_pairs(const dem_world *w, int i) {
    uint64_t h = DEMI_HASH_START;
    int j;
    for (j = 0; j < w->material_count; j++)
        h = demi_hash(h, &w->pairs[i*DEMI_MATERIALS + j].given, sizeof(dem_pair));
    return h;
}
/* What a shape is, not what was worked out from it. */
static uint64_t demi_digest_shape(const dem_world *w, int i) {
    const demi_shape *shape = &w->shapes[i];
    uint64_t h = demi_hash(DEMI_HASH_START, &shape->count, sizeof shape->count);
    h = demi_hash(h, &shape->kind, sizeof shape->kind);
    h = demi_hash(h, &shape->axes, sizeof shape->axes);
    h = demi_hash(h, &shape->inertia, sizeof shape->inertia);
    h = demi_hash(h, &shape->volume, sizeof shape->volume);
    return shape->count ? demi_hash(h, shape->parts, 4*(size_t)shape->count*sizeof(dem_real)) : h;
}
static uint64_t demi_digest_sieve(const dem_sieve_desc *s, uint64_t h) {
    const int which[] = {(int)s->kind, s->staggered, s->model};
    const dem_real sizes[] = {s->aperture, s->bar, s->length, s->thickness, s->lift, s->radius,
                              s->clearance};
    return demi_hash(demi_hash(h, which, sizeof which), sizes, sizeof sizes);
}
/* 0: a wall that was removed. */
static uint64_t demi_digest_wall(const dem_world *w, int i) {
    const demi_wall *wall = &w->walls[i];
    const int what[] = {wall->kind, wall->material, wall->inside, (int)wall->rule,
                        wall->vertex_count, wall->element_count, (int)wall->motion.kind};
    uint64_t h = demi_hash(DEMI_HASH_START, what, sizeof what);
    if (wall->kind == DEMI_WALL_NONE) return 0;
    h = demi_hash(h, &wall->radius, sizeof(dem_real));
    h = demi_hash(h, &wall->share, sizeof(dem_real));
    h = demi_hash(h, &wall->first, sizeof wall->first);
    if (wall->sieve.kind) h = demi_digest_sieve(&wall->sieve, h);
    if (wall->corners)
        h = demi_hash(h, wall->corners, (size_t)wall->element_count*sizeof(int32_t)*
                      (size_t)demi_wall_per(wall));
    if (wall->vertices)
        h = demi_hash(h, wall->vertices, (size_t)wall->vertex_count*3*sizeof(dem_real));
    return h ? h : 1;
}
static uint64_t demi_digest_field(const dem_world *w, int i) {
    const dem_field_desc *f = &w->fields[i].desc;
    uint64_t h = demi_hash(DEMI_HASH_START, &f->box, sizeof f->box);
    h = demi_hash(h, f->cells, sizeof f->cells);
    h = demi_hash(h, &f->start, sizeof f->start);
    h = demi_hash(h, &f->end, sizeof f->end);
    return demi_hash(h, &f->interval, sizeof f->interval);
}
static uint64_t demi_digest_feed(const dem_world *w, int i) {
    const dem_feed_desc *f = &demi_feed_at(w, i)->desc;
    const int what[] = {(int)f->material.id, f->class_count, f->limited, f->by_mass, f->round};
    const double when[] = {f->rate, f->start, f->end};
    uint64_t h = demi_hash(DEMI_HASH_START, what, sizeof what);
    h = demi_hash(h, when, sizeof when);
    h = demi_hash(h, f->radius, sizeof f->radius);
    h = demi_hash(h, f->amount, sizeof f->amount);
    h = demi_hash(h, &f->box, sizeof f->box);
    h = demi_hash(h, &f->velocity, sizeof f->velocity);
    h = demi_hash(h, &f->spread, sizeof f->spread);
    return demi_hash(h, &f->seed, sizeof f->seed);
}
static uint64_t demi_digest_outlet(const dem_world *w, int i) {
    const dem_outlet_desc *o = &demi_outlet_at(w, i)->desc;
    const int what[] = {(int)o->frame.id, o->class_count};
    const dem_real sizes[] = {o->beyond, o->wanted_min, o->wanted_max};
    uint64_t h = demi_hash(DEMI_HASH_START, what, sizeof what);
    h = demi_hash(h, sizes, sizeof sizes);
    h = demi_hash(h, &o->box, sizeof o->box);
    return demi_hash(h, o->radius, sizeof o->radius);
}

/* The parts of a scene: one row each. `none`: its number is not told in a sentence. */
typedef struct demi_scene_part {
    const char *name, *many;
    uint64_t (*digest)(const dem_world *w, int index);
} demi_scene_part;
enum { DEMI_PART_WALLS = 4, DEMI_PARTS = 8 };
static const demi_scene_part demi_scene_parts[DEMI_PARTS] = {
    {"the desc of the world", "descs", demi_digest_desc},
    {"material", "materials", demi_digest_material},
    {"the pairs (dem_pair_set) of material", "materials with pairs", demi_digest_pairs},
    {"shape", "shapes", demi_digest_shape},
    {"wall", "walls", demi_digest_wall},
    {"field", "fields", demi_digest_field},
    {"feed", "feeds", demi_digest_feed},
    {"outlet", "outlets", demi_digest_outlet}};
/* How many there are of each part, in the order of the rows. */
static void demi_scene_counts(const dem_world *w, int32_t *counts) {
    counts[0] = 1;
    counts[1] = counts[2] = w->material_count;
    counts[3] = w->shape_count;
    counts[DEMI_PART_WALLS] = w->wall_count;
    counts[5] = w->field_count;
    counts[6] = w->feed_count;
    counts[7] = w->outlet_count;
}
/* All of a scene in one number: do two processes hold the same one? */
static uint64_t demi_scene_digest(const dem_world *w) {
    uint64_t h = DEMI_HASH_START;
    int32_t counts[DEMI_PARTS];
    int part, i;
    demi_scene_counts(w, counts);
    h = demi_hash(h, counts, sizeof counts);
    for (part = 0; part < DEMI_PARTS; part++)
        for (i = 0; i < counts[part]; i++) {
            const uint64_t one = demi_scene_parts[part].digest(w, i);
            h = demi_hash(h, &one, sizeof one);
        }
    return h;
}

/* --- the state, visited in the order in which it is checked --- */

/* Numbers that are not arrays. */
static void demi_visit_numbers(dem_world *w, demi_stream *s) {
    DEMI_VISIT(s, w->bodies.count);          DEMI_VISIT(s, w->bodies.slot_count);
    DEMI_VISIT(s, w->domain_count);   DEMI_VISIT(s, w->join_room);
    DEMI_VISIT(s, w->bodies.orienting);      DEMI_VISIT(s, w->bodies.shaped);
    DEMI_VISIT(s, w->filed.count);    DEMI_VISIT(s, w->filed.rows);
    DEMI_VISIT(s, w->filed.stride);
    DEMI_VISIT(s, w->bodies.slot_free);      DEMI_VISIT(s, w->bodies.slot_pending);
    DEMI_VISIT(s, w->bodies.balance);        DEMI_VISIT(s, w->desc.search);
    DEMI_VISIT(s, w->clock);          DEMI_VISIT(s, w->stage);
    DEMI_VISIT(s, w->margin);         DEMI_VISIT(s, w->effects);
    DEMI_VISIT(s, w->levels);         DEMI_VISIT(s, w->booked);
}
/* By the table: what a row declares as state is in the file, and nothing else. */
static void demi_visit_bodies(dem_world *w, demi_stream *s) {
    int k;
    for (k = 0; k < DEMI_BODY_ARRAYS; k++) {
        const demi_body_array *a = &demi_body_arrays[k];
        const size_t n = (size_t)(a->who == DEMI_SLOTS ? w->bodies.slot_count : w->bodies.count);
        if (a->what && demi_has(w, a)) demi_visit(s, demi_data(w, a), n*a->item);
    }
}
/* Near pairs of one domain; their candidates are counted from the domain's first. */
static void demi_visit_near(dem_world *w, demi_stream *s, int d) {
    const demi_domain *domain = &w->domains[d];
    const size_t from = (size_t)d*(size_t)w->near.stride, r = sizeof(dem_real);
    const size_t remembering = (size_t)domain->near_end, all = (size_t)domain->near_shaped_end;
    int p, e, l;
    demi_visit(s, w->near.a + from, 4*all);
    demi_visit(s, w->near.b + from, 4*all);
    for (l = 0; l < 4; l++) {                   /* between these lie entries that nobody uses */
        const int begin = l == 0 ? 0 : l == 1 ? domain->near_cross
            : l == 2 ? domain->near_shaped : domain->near_shaped_cross;
        const int end = l == 0 ? domain->near_own : l == 1 ? domain->near_end
            : l == 2 ? domain->near_shaped_cross : domain->near_shaped_end;
        for (p = begin; p < end; p++) {
            const int32_t first = d*(l & 1 ? w->cross.stride : w->own.stride);
            int32_t k = s->from ? 0 : w->near.k[from + (size_t)p] - first;
            demi_visit(s, &k, sizeof k);
            if (s->from) w->near.k[from + (size_t)p] = k;      /* `first` is added when checked */
        }
    }
    for (e = 0; e < w->memory_stride; e++)
        demi_visit(s, w->near.memory + (from*(size_t)w->memory_stride +
                   (size_t)e*(size_t)w->near.stride), remembering*r);
    for (e = 0; e < DEMI_PAIR_COLUMNS && w->stage.pairs_changed && demi_many_species(w); e++)
        demi_visit(s, w->near.coef + (from*DEMI_PAIR_COLUMNS + (size_t)e*(size_t)w->near.stride),
                   remembering*r);
}
/* Candidates, near pairs, wall candidates: of a list that fits the bodies. */
static void demi_visit_lists(dem_world *w, demi_stream *s) {
    const int n = w->effects.species_count;
    int d, i;
    if (w->stage.list_valid && w->stage.pairs_changed && !demi_many_species(w))
        demi_visit(s, w->species_coef, (size_t)(n*n*DEMI_PAIR_COLUMNS)*sizeof(dem_real));
    for (d = 0; d < w->domain_count && w->stage.list_valid; d++) {
        const demi_domain *domain = &w->domains[d];
        const size_t walls = (size_t)domain->walls;
        for (i = 0; i < 2; i++) {
            demi_list *list = i ? &w->cross : &w->own;
            const size_t from = (size_t)d*(size_t)list->stride;
            const size_t pairs = (size_t)(i ? domain->cross : domain->own);
            if (!pairs) continue;
            demi_visit(s, list->a + from, 4*pairs);
            demi_visit(s, list->b + from, 4*pairs);
        }
        if (domain->near_shaped_end) demi_visit_near(w, s, d);
        if (!walls) continue;
        demi_visit(s, w->wall_body + d*w->wall_stride, walls*4);
        demi_visit(s, w->wall_id + d*w->wall_stride, walls*4);
        demi_visit(s, w->wall_element + d*w->wall_stride, walls*4);
        demi_visit(s, w->wall_gap + d*w->wall_stride, walls*sizeof(dem_real));
        demi_visit(s, w->wall_shift + 3*(size_t)d*(size_t)w->wall_stride,
                   3*walls*sizeof(dem_real));
    }
}
/* Contacts that last, with or without a list; memory on its way from one list to the next. */
static void demi_visit_contacts(dem_world *w, demi_stream *s) {
    int d;
    for (d = 0; d < w->domain_count; d++) {
        const demi_domain *domain = &w->domains[d];
        if (domain->kept)
            demi_visit(s, demi_kept_of(w, d),
                       (size_t)domain->kept*sizeof(demi_kept));
    }
    if (w->stage.list_valid || !w->filed.count) return;
    demi_visit(s, w->filed.start, ((size_t)w->filed.rows + 1)*4);
    demi_visit(s, w->filed.partner, (size_t)w->filed.count*4);
    demi_visit(s, w->filed.memory,
               (size_t)w->filed.count*(size_t)w->filed.stride*sizeof(dem_real));
}
/* Where walls are, what they bear, how they move; their geometry is the scene's. */
static void demi_visit_walls(dem_world *w, demi_stream *s) {
    int i;
    for (i = 0; i < w->wall_count; i++) {
        demi_wall *wall = &w->walls[i];
        dem_motion *m = &wall->motion;          /* all but pointers: they are the reader's own */
        demi_visit(s, &wall->home, sizeof wall->home);
        demi_visit(s, &wall->pose, sizeof wall->pose);
        demi_visit(s, &wall->mid, sizeof wall->mid);
        demi_visit(s, &wall->loads, sizeof wall->loads);
        DEMI_VISIT(s, m->kind);     DEMI_VISIT(s, m->velocity);   DEMI_VISIT(s, m->point);
        DEMI_VISIT(s, m->axis);     DEMI_VISIT(s, m->speed);      DEMI_VISIT(s, m->amplitude);
        DEMI_VISIT(s, m->frequency); DEMI_VISIT(s, m->phase);     DEMI_VISIT(s, m->start);
    }
}
/* Fields, feeds, outlets. */
static void demi_visit_measured(dem_world *w, demi_stream *s) {
    int i;
    for (i = 0; i < w->field_count; i++) {
        demi_field *f = &w->fields[i];
        const size_t cells = demi_field_cells(f);
        demi_visit(s, &f->samples, sizeof f->samples);
        demi_visit(s, &f->next, sizeof f->next);
        demi_visit(s, f->solid, cells*sizeof(double));
        demi_visit(s, f->mass, cells*sizeof(double));
        demi_visit(s, f->momentum, 3*cells*sizeof(double));
    }
    for (i = 0; i < w->feed_count; i++) {
        demi_feed *f = demi_feed_at(w, i);
        demi_visit(s, &f->state, sizeof f->state);
        demi_visit(s, &f->random, sizeof f->random);
        demi_visit(s, &f->next, sizeof f->next);
        demi_visit(s, &f->again, sizeof f->again);
    }
    for (i = 0; i < w->outlet_count; i++)
        demi_visit(s, &demi_outlet_at(w, i)->state, sizeof(dem_outlet_state));
}
/* Everything, in the one order that writing and reading share. */
static void demi_visit_state(dem_world *w, demi_stream *s) {
    demi_visit_numbers(w, s);
    demi_visit(s, w->domains, (size_t)w->domain_count*sizeof(demi_domain));
    demi_visit_bodies(w, s);
    demi_visit_lists(w, s);
    demi_visit_contacts(w, s);
    demi_visit_walls(w, s);
    demi_visit_measured(w, s);
}

/* --- writing --- */

typedef struct demi_checkpoint_head {
    char magic[8];
    uint32_t version, real_size, byte_order, int_size;
    uint64_t body_size;             /* bytes that follow the head, without the check sum */
    int32_t parts[DEMI_PARTS];      /* of the scene; as many digests follow */
} demi_checkpoint_head;

/* Of structs that are saved whole, and of what bodies keep: tells files of another dem.h. */
static uint32_t demi_checkpoint_layout(void) {
    const size_t sizes[] = {sizeof(demi_domain), sizeof(demi_kept), sizeof(demi_timing),
                            sizeof(demi_stages), sizeof(demi_margin), sizeof(demi_in_force),
                            sizeof(demi_levels), sizeof(demi_booked)};
    uint64_t h = demi_hash(DEMI_HASH_START, sizes, sizeof sizes);
    int k;
    for (k = 0; k < DEMI_BODY_ARRAYS; k++) {
        const size_t row[] = {demi_body_arrays[k].item, (size_t)demi_body_arrays[k].who,
                              (size_t)demi_body_arrays[k].what};
        h = demi_hash(h, row, sizeof row);
    }
    return (uint32_t)(h ^ h >> 32);
}
/* One number for each part of the scene, so that a refusal can name the part that differs. */
static void demi_visit_digests(const dem_world *w, demi_stream *s, const int32_t *counts) {
    int part, i;
    for (part = 0; part < DEMI_PARTS; part++)
        for (i = 0; i < counts[part]; i++) {
            uint64_t digest = demi_scene_parts[part].digest(w, i);
            demi_visit(s, &digest, sizeof digest);
        }
}
/* The first body whose state is not finite or out of the world; -1: none. */
static int demi_body_lost(const dem_world *w) {
    int i, k;
    size_t e;
    for (i = 0; i < w->bodies.count; i++) {
        for (k = 0; k < DEMI_BODY_ARRAYS; k++) {
            const demi_body_array *a = &demi_body_arrays[k];
            const dem_real *x;
            if (a->what < DEMI_REALS || !demi_has(w, a)) continue;
            x = (const dem_real *)(const void *)demi_datum(w, a, i);
            for (e = 0; e < a->item/sizeof *x; e++) if (!demi_finite(x[e])) return i;
        }
        if (demi_size(demi_at(w->bodies.pos + 4*i)) > DEMI_FARTHEST) return i;
    }
    return -1;
}
DEM_API dem_result dem_checkpoint_write(dem_world *w, const char *path) {
    if (demi_null(w, "dem_checkpoint_write", w, "world")) return DEM_ERROR_ARGUMENT;
    const int lost = demi_body_lost(w);
    demi_checkpoint_head head;
    demi_out out;
    demi_stream s = {0, 0, 0, 0, 0, 0, 0};
    dem_result result;
    uint64_t sum;
    if (lost >= 0)
        return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_checkpoint_write: body %u is no longer at a "
                         "finite place and speed: the run has blown up; go back to an earlier "
                         "checkpoint, %s is left as it was", (unsigned)w->bodies.slot[lost] + 1,
                         path ? path : "the file");
    result = demi_out_open(&out, w, "dem_checkpoint_write", path);
    if (result != DEM_OK) return result;
    if (w->stage.list_valid) w->filed.count = 0;      /* filed once, and taken up by the list */
    if (!w->filed.count) w->filed.rows = w->filed.stride = 0;
    memset(&head, 0, sizeof head);
    memcpy(head.magic, DEMI_CHECKPOINT_MAGIC, 8);
    head.version = DEMI_CHECKPOINT_VERSION;
    head.real_size = (uint32_t)sizeof(dem_real);
    head.byte_order = 0x01020304u;
    head.int_size = demi_checkpoint_layout();
    demi_scene_counts(w, head.parts);
    demi_visit_digests(w, &s, head.parts);      /* counts */
    demi_visit_state(w, &s);
    head.body_size = s.size;
    s.file = out.file;
    s.sum = DEMI_HASH_START;
    demi_visit(&s, &head, sizeof head);
    demi_visit_digests(w, &s, head.parts);
    demi_visit_state(w, &s);
    sum = s.sum;
    fwrite(&sum, 1, sizeof sum, out.file);
    return demi_out_close(&out);
}

/* --- reading: is it a checkpoint, whole, and of this scene? --- */

/* Is it a checkpoint, whole, and of a program like this one? Nothing behind the head is looked at
   before all of that is certain. */
static dem_result demi_checkpoint_check(dem_world *w, const char *path, const char *data,
                                        size_t size, demi_checkpoint_head *head) {
    const char *call = "dem_checkpoint_read";
    uint64_t sum;
    if (size < sizeof *head || memcmp(data, DEMI_CHECKPOINT_MAGIC, 8))
        return demi_fail(w, DEM_ERROR_FORMAT, "%s: %.200s: %s; write checkpoints with "
                         "dem_checkpoint_write", call, path,
                         size >= 8 && !memcmp(data, DEMI_CHECKPOINT_MAGIC, 8)
                         ? "is cut short within its head" : "is not a checkpoint");
    memcpy(head, data, sizeof *head);
    if (head->byte_order != 0x01020304u || head->version != DEMI_CHECKPOINT_VERSION)
        return demi_fail(w, DEM_ERROR_FORMAT, "%s: %.200s: is of checkpoint version %u%s, must be "
                         "%d; read it with the dem.h that wrote it", call, path,
                         (unsigned)head->version,
                         head->byte_order != 0x01020304u ? " and another byte order" : "",
                         (int)DEMI_CHECKPOINT_VERSION);
    if (head->real_size != sizeof(dem_real))
        return demi_fail(w, DEM_ERROR_FORMAT, "%s: %.200s: was written with DEM_REAL of %u bytes, "
                         "must be %u; build with the same precision", call, path,
                         (unsigned)head->real_size, (unsigned)sizeof(dem_real));
    if (head->body_size != (uint64_t)(size - sizeof *head) - sizeof sum)
        return demi_fail(w, DEM_ERROR_FORMAT, "%s: %.200s: has %llu bytes, must be %llu; it was "
                         "cut short or appended to", call, path, (unsigned long long)size,
                         (unsigned long long)(sizeof *head + head->body_size + sizeof sum));
    memcpy(&sum, data + size - sizeof sum, sizeof sum);
    if (sum != demi_hash(DEMI_HASH_START, data, size - sizeof sum))
        return demi_fail(w, DEM_ERROR_FORMAT, "%s: %.200s: its check sum does not match its "
                         "contents; the file is damaged", call, path);
    if (head->int_size != demi_checkpoint_layout())
        return demi_fail(w, DEM_ERROR_FORMAT, "%s: %.200s: was written by another dem.h, or one "
                         "whose compiler lays out memory in another way; read it with a program "
                         "built like the one that wrote it", call, path);
    return DEM_OK;
}
/* Says which part of the scene differs. A wall that the file's world had removed may still stand
   here: reading removes it. */
static dem_result demi_checkpoint_scene(dem_world *w, const char *path, demi_stream *s,
                                        const int32_t *parts) {
    const char *call = "dem_checkpoint_read", *advice = "create the world with the same desc, "
        "materials, pairs, shapes, walls, motions, fields, feeds and outlets as the one that "
        "wrote it, then read";
    int32_t counts[DEMI_PARTS];
    int part, i;
    demi_scene_counts(w, counts);
    for (part = 0; part < DEMI_PARTS; part++)
        if (parts[part] != counts[part])
            return demi_fail(w, DEM_ERROR_FORMAT, "%s: %.200s: belongs to another scene: %d %s "
                             "there, %d here (removed ones count); %s", call, path,
                             (int)parts[part], demi_scene_parts[part].many, (int)counts[part],
                             advice);
    for (part = 0; part < DEMI_PARTS; part++)
        for (i = 0; i < counts[part]; i++) {
            const uint64_t here = demi_scene_parts[part].digest(w, i);
            uint64_t there = 0;
            const char *how = "differs";
            char number[16] = "";
            demi_visit(s, &there, sizeof there);
            if (there == here || (part == DEMI_PART_WALLS && !there)) continue;
            if (part == DEMI_PART_WALLS && !here) how = "was removed here and stands there";
            if (part) snprintf(number, sizeof number, " %d", i + 1);
            return demi_fail(w, DEM_ERROR_FORMAT, "%s: %.200s: belongs to another scene: %s%s %s; "
                             "%s", call, path, demi_scene_parts[part].name, number, how, advice);
        }
    return DEM_OK;
}

/* ---------------------------------------------------------------------------------------------
   >>restore
   Reading a checkpoint fills a twin, an empty world of the same scene. A check sum only tells that
   a file is as it was written, not that what was written makes sense: so every count is checked
   before room is made for it, and every index and length before anything follows it. When all is
   right the twin's state takes the place of the world's; until then the world is as it was.
   --------------------------------------------------------------------------------------------- */

/* Copies of walls, fields, feeds and outlets, the domains: what state is read into. 0 when memory
   ran out. */
static int demi_twin_parts(dem_world *t, const dem_world *w) {
    int i;
    t->domains = (demi_domain *)demi_hold(t, DEMI_RUN, DEMI_DOMAINS, sizeof(demi_domain));
    t->cross_incoming_start = (int *)demi_hold(t, DEMI_RUN, DEMI_DOMAINS + 1, sizeof(int));
    t->walls = (demi_wall *)demi_hold(t, DEMI_RUN, (size_t)w->wall_count, sizeof(demi_wall));
    t->fields = (demi_field *)demi_hold(t, DEMI_RUN, (size_t)w->field_count, sizeof(demi_field));
    if (!t->domains || !t->cross_incoming_start || (w->wall_count && !t->walls) ||
        (w->field_count && !t->fields) ||
        !DEMI_GROW(t, t->feeds, (size_t)w->feed_count) ||
        !DEMI_GROW(t, t->outlets, (size_t)w->outlet_count)) return 0;
    t->wall_count = w->wall_count;
    t->feed_count = w->feed_count;
    t->outlet_count = w->outlet_count;
    if (w->wall_count) memcpy(t->walls, w->walls, (size_t)w->wall_count*sizeof(demi_wall));
    for (i = 0; i < w->feed_count; i++) *demi_feed_at(t, i) = *demi_feed_at(w, i);
    for (i = 0; i < w->outlet_count; i++) *demi_outlet_at(t, i) = *demi_outlet_at(w, i);
    for (i = 0; i < w->field_count; i++) {
        const size_t cells = demi_field_cells(&w->fields[i]);
        demi_field *f = &t->fields[i];
        *f = w->fields[i];
        f->solid = (double *)demi_hold(t, DEMI_RUN, cells, sizeof(double));
        f->mass = (double *)demi_hold(t, DEMI_RUN, cells, sizeof(double));
        f->momentum = (double *)demi_hold(t, DEMI_RUN, cells, 3*sizeof(double));
        t->field_count = i + 1;
        if (!f->solid || !f->mass || !f->momentum) return 0;
    }
    return 1;
}
/* An empty world of the scene of w: it has walls, fields, feeds and outlets of its own, but looks
   at w's materials, shapes and geometry. Null when memory ran out. */
static dem_world *demi_twin_make(dem_world *w) {
    dem_world *t = (dem_world *)demi_alloc(w, 1, sizeof *t);
    if (!t) return 0;
    t->desc = w->desc;
    t->asked = w->asked;
    t->material_count = w->material_count;
    memcpy(t->materials, w->materials, sizeof t->materials);
    t->pairs = w->pairs;
    t->shape_count = w->shape_count;
    t->shapes = w->shapes;
    t->normal = (int)w->desc.normal_law;
    t->bodies.backward = w->bodies.backward;
    if (demi_twin_parts(t, w)) return t;
    demi_free_chain(t, DEMI_RUN);
    demi_free(w, t);
    return 0;
}
static void demi_twin_free(dem_world *w, dem_world *t) {
    demi_free_chain(t, DEMI_RUN);
    demi_free(w, t);
}
/* The twin's state takes the place of the world's. */
static void demi_twin_adopt(dem_world *w, dem_world *t) {
    size_t bytes;
    int i;
    for (i = 0; i < w->wall_count; i++)
        if (t->walls[i].kind == DEMI_WALL_NONE) demi_wall_free(w, &w->walls[i]);
    demi_free_chain(w, DEMI_RUN);
    t->chains[DEMI_SCENE] = w->chains[DEMI_SCENE];
    bytes = w->bytes + t->bytes;
    memcpy(t->error, w->error, sizeof t->error);
    memcpy(t->refusal, w->refusal, sizeof t->refusal);
    memcpy(t->refused_calls, w->refused_calls, sizeof t->refused_calls);
    t->refused = w->refused;
    *w = *t;
    w->bytes = bytes;
    demi_free(w, t);
}

/* --- reading: does what it says make sense? Each of these checks one part of the twin, right after
       it was read, and answers 0 with a sentence when not --- */

typedef struct demi_reader {
    dem_world *w, *t;
    const char *path;
    demi_stream s;
} demi_reader;

/* The check sum is right and a number cannot be: says which. Answers 0. */
static int demi_lie(const demi_reader *r, const char *what, long long which) {
    char number[32] = "";
    if (which >= 0) snprintf(number, sizeof number, " %lld", which + 1);
    demi_fail(r->w, DEM_ERROR_FORMAT, "dem_checkpoint_read: %.200s: %s%s cannot be, although the "
              "check sum is right; the file was altered, or the run that wrote it had blown up: "
              "use an older one", r->path, what, number);
    return 0;
}
/* Are so many items of `size` bytes left in the file? */
static int demi_left(const demi_reader *r, int64_t count, size_t size) {
    return count >= 0 && (uint64_t)count <= r->s.left/size;
}
/* Finite, and at least `least`. */
static int demi_sane(double x, double least) { return demi_finite_double(x) && x >= least; }

/* Counts bound what is allocated and read next, so they come first. */
static int demi_numbers_check(const demi_reader *r) {
    const dem_world *t = r->t, *w = r->w;
    const int tangent = demi_tangent_meant(w), rolling = demi_rolling_meant(w);
    const double positive[] =
        {t->margin.skin, t->margin.gone, t->margin.walls_gone, t->margin.skin_auto,
        t->clock.assumed_speed, t->margin.span, t->margin.age, t->margin.slack, t->margin.change,
            t->margin.last_change,
        t->margin.creep, t->booked.speed_max, t->clock.half_kick, (double)t->effects.radius_min,
            (double)t->effects.radius_max,
        (double)t->clock.dt};
    size_t i;
    int k;
    if (!demi_left(r, t->bodies.count, demi_body_size(t)) ||
        !demi_left(r, t->bodies.slot_count, 8) ||
        t->bodies.count > INT_MAX/64 || t->bodies.slot_count > INT_MAX/64 ||
            t->bodies.count > t->bodies.slot_count)
        return demi_lie(r, "its number of bodies or of slots", -1);
    if (t->domain_count < 0 || t->domain_count > DEMI_DOMAINS ||
        (t->stage.list_valid && (!t->domain_count ||
                           t->domain_count > demi_domains_for(4*t->bodies.count + 16))) ||
        !demi_left(r, t->domain_count, sizeof(demi_domain)))
        return demi_lie(r, "its number of domains", -1);
    if (t->join_room < 0 || t->join_room > DEMI_JOIN_MOST)
        return demi_lie(r, "the room in its lists", -1);
    if ((int)t->desc.search < 0 || (int)t->desc.search >= DEMI_SEARCHES || t->levels.count < 0 ||
        t->levels.count > DEMI_LEVELS || (w->asked.search != DEM_SEARCH_AUTO &&
                                         t->desc.search != w->desc.search))
        return demi_lie(r, "its search", -1);
    if (t->bodies.shaped < 0 || t->bodies.shaped > (t->bodies.orienting ? t->bodies.count : 0) ||
        (w->asked.orientations && !t->bodies.orienting))
        return demi_lie(r, "its number of bodies that are not spheres", -1);
    if (!demi_left(r, t->filed.count, 4) || t->filed.rows < 0 ||
        t->filed.rows > t->bodies.slot_count ||
        t->filed.stride < 0 || t->filed.stride > DEMI_MEMORY ||
            (t->stage.list_valid && t->filed.count))
        return demi_lie(r, "its contact memory", -1);
    if (((t->effects.tangent || t->stage.list_valid) && t->effects.tangent != tangent &&
         t->effects.tangent != DEM_TANGENT_NONE) || ((t->effects.rolling || t->stage.list_valid) &&
         t->effects.rolling != rolling && t->effects.rolling != DEM_ROLLING_NONE) ||
             (t->effects.uniform & ~1) || t->effects.species_count < 0 ||
             t->effects.species_count > (t->effects.uniform ? 1 : DEMI_SPECIES + 1))
        return demi_lie(r, "the laws in force", -1);
    for (k = 0; k < t->effects.species_count && k < DEMI_SPECIES; k++)
        if (t->effects.species[k].material < 1 ||
            t->effects.species[k].material > t->material_count)
            return demi_lie(r, "its table of species", -1);
    for (i = 0; i < sizeof positive/sizeof *positive; i++)
        if (!demi_sane(positive[i], 0))
            return demi_lie(r, "its time, time step, skin or one of the lengths that go with the "
                            "list", -1);
    if (!demi_finite_double(t->clock.time) || fabs(t->clock.time) > DEMI_FARTHEST ||
        !demi_finite_double(t->clock.since.time) || fabs(t->clock.since.time) > DEMI_FARTHEST ||
        t->clock.since.steps > t->clock.steps || !demi_sane(t->clock.since.dt, 0) ||
        !demi_finite_double(t->clock.run_end) ||
            (t->stage.dt_valid && t->bodies.count && !(t->clock.dt > 0)) ||
        (t->stage.dt_valid && t->bodies.count && w->desc.dt > 0 &&
         (t->clock.dt < w->desc.dt || t->clock.dt > w->desc.dt)))
        return demi_lie(r, "its time or time step", -1);
    if (t->bodies.balance.present != (uint64_t)t->bodies.count ||
        t->bodies.balance.inserted != t->bodies.balance.present + t->bodies.balance.removed +
            t->bodies.balance.left)
        return demi_lie(r, "its balance of bodies", -1);
    return 1;
}
/* Counts of domain d; begins where the one before ended. */
static int demi_domain_check(const demi_reader *r, int d) {
    const dem_world *t = r->t;
    const demi_domain *o = &t->domains[d];
    const int64_t counts[] = {o->own, o->cross, o->walls, o->near_own,
        (int64_t)o->near_end - o->near_cross, (int64_t)o->near_shaped_cross - o->near_shaped,
        (int64_t)o->near_shaped_end - o->near_shaped_cross, o->contacts,
        o->kept, o->kept_walls, o->near_cross, o->near_end, o->near_shaped,
        o->near_shaped_cross, o->near_shaped_end};
    const int group = DEMI_LANES;
    size_t i;
    for (i = 0; i < sizeof counts/sizeof *counts; i++)
        if (counts[i] < 0 || counts[i] > INT_MAX/64) return 0;
    if (!demi_left(r, o->kept, sizeof(demi_kept)) ||
        (o->kept && !t->wall_count && !t->bodies.orienting)) return 0;
    if (!t->stage.list_valid) return 1;
    return o->begin == (d ? t->domains[d - 1].end : 0) && o->end >= o->begin &&
           o->end <= t->bodies.count && (d + 1 < t->domain_count || o->end == t->bodies.count) &&
           demi_left(r, o->own, 8) && demi_left(r, o->cross, 8) &&
           demi_left(r, o->walls, 12 + 4*sizeof(dem_real)) &&
           demi_left(r, o->near_shaped_end, 8) &&
           o->near_cross == (o->near_own + group - 1)/group*group &&
           o->near_shaped == (o->near_end + group - 1)/group*group &&
           o->near_own + o->near_shaped_cross - o->near_shaped <= o->own &&
           o->near_end - o->near_cross + o->near_shaped_end - o->near_shaped_cross <= o->cross;
}
/* Bodies of all domains in a row; without a list, as much of it as the next one starts from. */
static int demi_domains_check(const demi_reader *r) {
    dem_world *t = r->t;
    int d;
    for (d = 0; d < t->domain_count; d++) {
        demi_domain *o = &t->domains[d];
        if (!demi_domain_check(r, d)) return demi_lie(r, "the counts of domain", d);
        o->overflow = 0;
        if (t->stage.list_valid) continue;
        /* of a list that is no more */
        o->begin = DEMI_MIN(DEMI_MAX(o->begin, 0), t->bodies.count);
        o->end = DEMI_MIN(DEMI_MAX(o->end, o->begin), t->bodies.count);
    }
    return 1;
}
/* Slots: those of bodies, and two chains of free ones that nothing else is in. */
static int demi_slots_check(const demi_reader *r, unsigned char *seen) {
    const dem_world *t = r->t;
    int i, chain, left = t->bodies.slot_count - t->bodies.count;
    for (i = 0; i < t->bodies.count; i++) {
        const uint32_t slot = t->bodies.slot[i];
        if (slot >= (uint32_t)t->bodies.slot_count || t->bodies.slot_index[slot] != i)
            return demi_lie(r, "the slot of body", i);
    }
    for (chain = 0; chain < 2; chain++) {
        int slot = chain ? t->bodies.slot_pending : t->bodies.slot_free;
        while (slot != -1) {
            if (slot < 0 || slot >= t->bodies.slot_count || seen[slot]++ ||
                t->bodies.slot_index[slot] >= 0 ||
                t->bodies.slot_index[slot] < -2 - t->bodies.slot_count || !left--)
                return demi_lie(r, "a chain of free slots", -1);
            slot = -2 - t->bodies.slot_index[slot];
        }
    }
    return left == 0 ? 1 : demi_lie(r, "the number of free slots", -1);
}
static dem_real demi_quat_size2(const dem_real *q) {
    return q[0]*q[0] + q[1]*q[1] + q[2]*q[2] + q[3]*q[3];
}
/* Numbers of bodies that can be: finite, positive where they must be, of materials and shapes that
   exist. */
static int demi_bodies_sane(const demi_reader *r) {
    const dem_world *t = r->t;
    const int lost = demi_body_lost(t);
    int i, k, shaped = 0;
    if (lost >= 0) return demi_lie(r, "a number of body", lost);
    for (i = 0; i < t->bodies.count; i++) {
        if (!(t->bodies.pos[4*i + 3] > 0) ||
            !demi_sane((double)t->bodies.mass[i], 0) || !(t->bodies.mass[i] > 0) ||
            !demi_sane((double)t->bodies.inv_mass[i], 0) ||
                !demi_sane((double)t->bodies.inv_inertia[i], 0))
            return demi_lie(r, "position, radius or mass of body", i);
        if (t->bodies.material[i] < 1 || t->bodies.material[i] > t->material_count)
            return demi_lie(r, "the material of body", i);
        if (!t->bodies.orienting) continue;
        if (t->bodies.shape[i] < 0 || t->bodies.shape[i] > t->shape_count)
            return demi_lie(r, "the shape of body", i);
        if (!(demi_quat_size2(t->bodies.orient + 4*i) > DEM_R(0.98)) ||
            !(demi_quat_size2(t->bodies.orient + 4*i) < DEM_R(1.02)))
            return demi_lie(r, "the orientation of body", i);
        if (!t->bodies.shape[i]) continue;
        shaped++;
        for (k = 0; k < 3; k++)
            if (!(t->bodies.moment[4*i + k] > 0)) return demi_lie(r, "the inertia of body", i);
    }
    return shaped == t->bodies.shaped ? 1 : demi_lie(r, "the number of shaped bodies", -1);
}
/* Near pairs p = begin .. end - 1 of domain d: entries of this list, ascending, all of spheres or
   none; from here on counted in all domains. */
static int demi_near_check(const demi_reader *r, int d, const demi_list *list, int count, int begin,
                           int end, int shaped) {
    dem_world *t = r->t;
    const int first = d*list->stride;
    int p, last = -1;
    for (p = begin; p < end; p++) {
        const int at = d*t->near.stride + p, k = t->near.k[at];
        if (k <= last || k >= count || t->near.a[at] != list->a[first + k] ||
            t->near.b[at] != list->b[first + k] ||
            shaped != (demi_shape_of(t, t->near.a[at]) || demi_shape_of(t, t->near.b[at])) ||
            (!shaped && !demi_species_has(t, t->near.a[at])) ||
            (!shaped && !demi_species_has(t, t->near.b[at])))
            return demi_lie(r, "a near pair of domain", d);
        last = k;
        t->near.k[at] = first + k;
    }
    return 1;
}
/* Every index in the lists: a pair stands where its lower body is, near pairs are candidates,
   elements exist. After that steps may trust them. */
static int demi_lists_check(const demi_reader *r) {
    dem_world *t = r->t;
    int d, l, k;
    for (d = 0; d < t->domain_count && t->stage.list_valid; d++) {
        const demi_domain *o = &t->domains[d];
        for (l = 0; l < 2; l++) {
            const demi_list *list = l ? &t->cross : &t->own;
            const int count = l ? o->cross : o->own, first = d*list->stride;
            for (k = first; k < first + count; k++) {
                const int a = list->a[k], b = list->b[k];
                if (a < o->begin || a >= o->end || b <= a || b >= t->bodies.count ||
                    (b >= o->end) != l)
                    return demi_lie(r, "a candidate pair of domain", d);
            }
            if (!demi_near_check(r, d, list, count, l ? o->near_cross : 0,
                                 l ? o->near_end : o->near_own, 0) ||
                !demi_near_check(r, d, list, count, l ? o->near_shaped_cross : o->near_shaped,
                                 l ? o->near_shaped_end : o->near_shaped_cross, 1)) return 0;
        }
        for (k = d*t->wall_stride; k < d*t->wall_stride + o->walls; k++) {
            const int wall = t->wall_id[k], body = t->wall_body[k];
            if (body < o->begin || body >= o->end || wall < 0 || wall >= t->wall_count ||
                t->walls[wall].kind == DEMI_WALL_NONE || t->wall_element[k] < 0 ||
                t->wall_element[k] >= t->walls[wall].element_count ||
                !demi_finite3(demi_at(t->wall_shift + 3*(size_t)k)) ||
                (k > d*t->wall_stride && body < t->wall_body[k - 1]))
                return demi_lie(r, "a wall candidate of domain", d);
        }
    }
    return 1;
}
/* Contacts that last: of bodies, or of slots while there is no list. */
static int demi_contacts_check(const demi_reader *r) {
    const dem_world *t = r->t;
    const int who = t->stage.list_valid ? t->bodies.count : t->bodies.slot_count;
    int d, k;
    for (d = 0; d < t->domain_count; d++) {
        for (k = 0; k < t->domains[d].kept; k++) {
            const demi_kept *c = demi_kept_of(t, d) + k;
            if (c->a < 0 || c->a >= who || c->b < -1 || c->b >= who || !demi_finite3(c->shift) ||
                (c->b >= 0 && !t->bodies.orienting) ||
                    (c->b < 0 && (c->wall < 0 || c->wall >= t->wall_count ||
                 (t->stage.list_valid && t->walls[c->wall].kind == DEMI_WALL_NONE))))
                return demi_lie(r, "a contact of domain", d);
        }
    }
    if (t->stage.list_valid || !t->filed.count) return 1;
    for (k = 0; k <= t->filed.rows; k++)
        if (t->filed.start[k] < (k ? t->filed.start[k - 1] : 0) ||
            t->filed.start[k] > t->filed.count || (!k && t->filed.start[k]))
            return demi_lie(r, "contact memory of slot", k);
    if (t->filed.start[t->filed.rows] != t->filed.count)
        return demi_lie(r, "contact memory of slot", t->filed.rows);
    for (k = 0; k < t->filed.count; k++) {
        const int32_t p = t->filed.partner[k], other = p < 0 ? ~p : p;
        if (other >= t->bodies.slot_count) return demi_lie(r, "a partner in contact memory, entry",
                                                           k);
    }
    return 1;
}
/* A rotation, as far as its numbers tell, and a place that can be. */
static int demi_pose_sane(const dem_pose *p) {
    int k;
    for (k = 0; k < 9; k++)
        if (!demi_finite(p->rotation[k]) || DEMI_ABS(p->rotation[k]) > 2) return 0;
    return demi_pose_finite(p) && demi_size(p->position) <= DEMI_FARTHEST;
}
/* Poses turn and do not stretch; motions are of the kind that the scene has. */
static int demi_walls_check(const demi_reader *r) {
    int i;
    for (i = 0; i < r->t->wall_count; i++) {
        const demi_wall *wall = &r->t->walls[i], *own = &r->w->walls[i];
        const dem_motion *m = &wall->motion;
        if (wall->kind == DEMI_WALL_NONE) continue;
        if (!demi_pose_sane(&wall->home) || !demi_pose_sane(&wall->pose) ||
            !demi_pose_sane(&wall->mid)) return demi_lie(r, "the pose of wall", i);
        if (m->kind != own->motion.kind || !demi_finite3(m->velocity) || !demi_finite3(m->point) ||
            !demi_finite3(m->axis) || !demi_finite(m->speed) || !demi_finite(m->amplitude) ||
            !demi_finite(m->frequency) || !demi_finite(m->phase) || !demi_finite_double(m->start))
            return demi_lie(r, "the motion of wall", i);
    }
    return 1;
}
/* What fields and feeds count cannot be more than they were given. */
static int demi_measured_check(const demi_reader *r) {
    int i, k;
    for (i = 0; i < r->t->field_count; i++)
        if (!demi_finite_double(r->t->fields[i].next))
            return demi_lie(r, "the time of the next sample of field", i);
    for (i = 0; i < r->t->feed_count; i++) {
        const demi_feed *f = demi_feed_at(r->t, i);
        if (f->next < -1 || f->next >= f->desc.class_count || !demi_sane(f->state.mass, 0))
            return demi_lie(r, "the state of feed", i);
        for (k = 0; k < f->desc.class_count; k++)
            if (f->desc.limited && f->state.fed[k] > f->limit[k])
                return demi_lie(r, "the state of feed", i);
    }
    return 1;
}

/* --- reading: room, and what follows from the rest --- */

/* Bodies get their room as if they were added. */
static int demi_twin_bodies_room(dem_world *t) {
    const int orienting = t->bodies.orienting, count = t->bodies.count,
        slots = t->bodies.slot_count;
    int ok;
    /* nothing to keep yet */
    t->bodies.orienting = t->bodies.count = t->bodies.slot_count = 0;
    ok = demi_bodies_reserve(t, (size_t)slots) && (!orienting || demi_orient_begin(t));
    t->bodies.count = count;
    t->bodies.slot_count = slots;
    return ok;
}
/* The lists' rows are as long as the longest asks for, and as a rebuild would make them. */
static int demi_twin_lists_room(dem_world *t) {
    int most[5] = {0, 0, 0, 0, 0}, crowd[DEMI_DOMAINS], d, k;
    const int each = t->domain_count ? t->bodies.count/t->domain_count : 0;
    memset(crowd, 0, sizeof crowd);
    for (d = 0; d < t->domain_count; d++) {
        const demi_domain *o = &t->domains[d];
        const int counts[] = {t->stage.list_valid ? o->own : 0, t->stage.list_valid ? o->cross : 0,
                              t->stage.list_valid ? o->near_shaped_end : 0, t->stage.list_valid
                                  ? o->walls : 0,
                              t->domain_count > 1};
        for (k = 0; k < 5; k++) most[k] = DEMI_MAX(most[k], counts[k]);
        crowd[d] = o->kept;
    }
    if (t->stage.list_valid) {
        most[0] = DEMI_MAX(most[0], DEMI_MAX(64, each*3));
        most[1] = DEMI_MAX(most[1], most[4] ? DEMI_MAX(64, each*3)/4 : 0);
        most[2] = DEMI_MAX(most[2], DEMI_MAX(64, each*5/2));
        most[3] = DEMI_MAX(most[3], 64);
    }
    for (k = 0; k < 4; k++) if (k != 2) most[k] += t->join_room;
    most[2] = (most[2] + DEMI_LANES - 1)/DEMI_LANES*DEMI_LANES + DEMI_LANES;
    demi_kept_lay(t, t->stage.list_valid ? t->domain_count : 0, crowd, t->kept_first);
    if (!DEMI_GROW(t, t->wall_sums, (size_t)t->domain_count*(size_t)t->wall_count) ||
        !DEMI_GROW(t, t->kept_now, (size_t)t->kept_first[DEMI_DOMAINS]) ||
        !DEMI_GROW(t, t->kept_next, (size_t)t->kept_first[DEMI_DOMAINS]) ||
        !demi_carry_reserve(t, t->filed.rows, t->filed.count, t->filed.stride)) return 0;
    return !t->stage.list_valid ||
           (demi_list_reserve(t, &t->own, t->domain_count, most[0]) &&
            demi_list_reserve(t, &t->cross, t->domain_count, most[1]) &&
            demi_species_room(t) &&
            demi_near_reserve(t, &t->near, t->domain_count, most[2]) &&
            demi_wall_lists_reserve(t, most[3]) &&
            DEMI_GROW(t, t->quiet, (size_t)(t->bodies.count/DEMI_SOME + t->domain_count + 1)));
}
/* What follows from the rest, and is not stored. 0 when memory ran out. */
static int demi_twin_follow(dem_world *t) {
    const demi_periods p = demi_periods_of(t);
    int d, k, l;
    demi_image_shifts(t);
    demi_walls_repeat(t);
    for (k = 0; k < t->wall_count; k++) t->walls[k].symmetric = demi_wall_symmetric(&t->walls[k]);
    demi_kernel_choose(t);
    if (!t->stage.list_valid) return 1;
    if (!t->stage.pairs_changed) demi_species_lay(t);
    demi_species_vary(t);
    if (t->bodies.shaped && !demi_centres_lay(t)) return 0;
    for (d = 0; d < t->domain_count; d++) {
        const demi_domain *o = &t->domains[d];
        const int first = d*t->near.stride;
        for (l = 0; l < 2; l++) {
            demi_list *list = l ? &t->cross : &t->own;
            const int begin = d*list->stride, count = l ? o->cross : o->own;
            for (k = begin; k < begin + count; k++)
                list->image[k] = demi_pair_image(t, &p, list->a[k], list->b[k]);
        }
        for (k = demi_near_first(o); k < o->near_end; k = demi_near_next(o, k)) {
            const int a = t->near.a[first + k], b = t->near.b[first + k];
            t->near.image[first + k] = demi_pair_image(t, &p, a, b);
            if (!t->effects.uniform && !(t->stage.pairs_changed && demi_many_species(t)))
                demi_near_coefs(t, &t->near, d, k, a, b);
        }
        for (k = o->near_shaped; k < o->near_shaped_end; k++)
            t->near.image[first + k] = demi_pair_image(t, &p, t->near.a[first + k],
                                                       t->near.b[first + k]);
        demi_near_adopt(t, d);
    }
    t->touching_valid = 0;
    if (!demi_cross_index(t)) return 0;
    for (d = 0; d < t->domain_count; d++) demi_domain_quiet(t, d);
    return 1;
}

/* Fills the twin from the rest of the file. A memory error has no sentence yet. */
static dem_result demi_twin_read(demi_reader *r, unsigned char **seen) {
    dem_world *t = r->t;
    demi_stream *s = &r->s;
    demi_visit_numbers(t, s);
    if (s->cut) demi_lie(r, "its length", -1);
    if (s->cut || !demi_numbers_check(r)) return DEM_ERROR_FORMAT;
    demi_effects_memory(t);
    demi_visit(s, t->domains, (size_t)t->domain_count*sizeof(demi_domain));
    if (!demi_domains_check(r)) return DEM_ERROR_FORMAT;
    *seen = (unsigned char *)demi_alloc(t, (size_t)t->bodies.slot_count + 1, 1);
    if (!*seen || !demi_twin_bodies_room(t) || !demi_twin_lists_room(t)) return DEM_ERROR_MEMORY;
    demi_visit_bodies(t, s);
    if (!demi_slots_check(r, *seen) || !demi_bodies_sane(r)) return DEM_ERROR_FORMAT;
    demi_visit_lists(t, s);
    demi_visit_contacts(t, s);
    if (!demi_lists_check(r) || !demi_contacts_check(r)) return DEM_ERROR_FORMAT;
    demi_visit_walls(t, s);
    demi_visit_measured(t, s);
    if (s->cut || s->left) demi_lie(r, "its length", -1);
    if (s->cut || s->left || !demi_walls_check(r) || !demi_measured_check(r))
        return DEM_ERROR_FORMAT;
    return demi_twin_follow(t) ? DEM_OK : DEM_ERROR_MEMORY;
}
/* Reads a checkpoint from memory. */
static dem_result demi_checkpoint_parse(dem_world *w, const char *path, const char *data,
                                        size_t size) {
    demi_checkpoint_head head;
    demi_reader r;
    unsigned char *seen = 0;
    int i;
    dem_result result = demi_checkpoint_check(w, path, data, size, &head);
    if (result != DEM_OK) return result;
    memset(&r, 0, sizeof r);
    r.w = w;
    r.path = path;
    r.s.from = data + sizeof head;
    r.s.left = (size_t)head.body_size;
    {
        demi_stream digests = r.s;              /* once to compare, once to see what was removed */
        result = demi_checkpoint_scene(w, path, &digests, head.parts);
    }
    if (result != DEM_OK) return result;
    r.t = demi_twin_make(w);
    if (!r.t) return demi_no_memory(w, "dem_checkpoint_read");
    for (i = 0; i < DEMI_PARTS; i++) {
        int k;
        for (k = 0; k < head.parts[i]; k++) {
            uint64_t digest = 0;
            demi_visit(&r.s, &digest, sizeof digest);
            if (i == DEMI_PART_WALLS && !digest)
                memset(&r.t->walls[k], 0, sizeof r.t->walls[k]);
        }
    }
    result = demi_twin_read(&r, &seen);
    demi_free(r.t, seen);
    if (result == DEM_OK) {
        demi_twin_adopt(w, r.t);
        return DEM_OK;
    }
    demi_twin_free(w, r.t);
    return result == DEM_ERROR_MEMORY ? demi_no_memory(w, "dem_checkpoint_read") : result;
}
/* What a checkpoint would hold, in memory: the same visit, so that a copy has what a restart has.
   Null when that ran out. */
static char *demi_state_keep(dem_world *w, size_t *size) {
    dem_world look = *w;
    demi_stream s = {0, 0, 0, 0, 0, 0, 0};
    char *bytes;
    if (look.stage.list_valid) look.filed.count = 0;  /* as dem_checkpoint_write has it */
    if (!look.filed.count) look.filed.rows = look.filed.stride = 0;
    demi_visit_state(&look, &s);
    *size = s.size;
    bytes = (char *)demi_alloc(w, s.size + 1, 1);
    s.to = bytes;
    if (bytes) demi_visit_state(&look, &s);
    return bytes;
}
/* A world in that state, to be tried out: it looks at the shapes and the geometry of walls of w,
   whose facets must have been weighed, and has all else for itself. Null when memory ran out. */
static dem_world *demi_twin_in_state(dem_world *w, const char *bytes, size_t size) {
    demi_reader r;
    unsigned char *seen = 0;
    dem_result result;
    memset(&r, 0, sizeof r);
    r.w = w;
    r.path = "a copy of the world";
    r.s.from = bytes;
    r.s.left = size;
    r.t = demi_twin_make(w);
    if (!r.t) return 0;
    r.t->pairs = (demi_pair *)demi_hold(r.t, DEMI_RUN, (size_t)DEMI_MATERIALS*DEMI_MATERIALS,
                                        sizeof(demi_pair));
    if (r.t->pairs)
        memcpy(r.t->pairs, w->pairs, (size_t)DEMI_MATERIALS*DEMI_MATERIALS*sizeof(demi_pair));
    result = r.t->pairs ? demi_twin_read(&r, &seen) : DEM_ERROR_MEMORY;
    demi_free(r.t, seen);
    r.t->facets_valid = 1;
    if (result == DEM_OK) return r.t;
    demi_twin_free(w, r.t);
    return 0;
}

DEM_API dem_result dem_checkpoint_read(dem_world *w, const char *path) {
    if (demi_null(w, "dem_checkpoint_read", w, "world")) return DEM_ERROR_ARGUMENT;
    char *bytes = 0;
    size_t size = 0;
    dem_result result = demi_load(w, "dem_checkpoint_read", path, &bytes, &size);
    if (result == DEM_OK)
        result = demi_checkpoint_parse(w, path, bytes, size);
    demi_free(w, bytes);
    return result;
}

/* ---------------------------------------------------------------------------------------------
   >>trials
   What a choice costs and what it changes, tried on copies of the user's own scene. A trial is a
   row: what it changes. Each runs several times, from places that hardly differ: what a choice
   changes counts only as far as it is more than what chance does. Copies live within the
   call; nothing of the world itself is stepped.
   --------------------------------------------------------------------------------------------- */
DEM_API double dem_observe_height(const dem_world *w, void *user) {
    const dem_totals t = dem_totals_get(w);
    dem_vec3 up;
    (void)user;
    if (!w) return 0;
    up = demi_dot(w->desc.gravity, w->desc.gravity) > 0
        ? demi_scale(w->desc.gravity, -1/demi_length(w->desc.gravity)) : demi_v(0, 0, 1);
    return t.centre[0]*(double)up.x + t.centre[1]*(double)up.y + t.centre[2]*(double)up.z;
}
DEM_API double dem_observe_kinetic(const dem_world *w, void *user) {
    const dem_totals t = dem_totals_get(w);
    (void)user;
    return t.kinetic + t.rotational;
}
DEM_API double dem_observe_contacts(const dem_world *w, void *user) {
    const dem_counters c = dem_counters_get(w);
    int d, kept = 0;
    (void)user;
    for (d = 0; w && d < w->domain_count && w->stage.list_valid; d++)
        kept += w->domains[d].kept - w->domains[d].kept_walls;
    return w && w->bodies.count ? (2.0*(c.contacts + kept) + c.wall_contacts)/w->bodies.count : 0;
}
DEM_API double dem_observe_walls(const dem_world *w, void *user) {
    double sum = 0;
    int i;
    (void)user;
    for (i = 0; w && i < w->wall_count; i++) sum += (double)demi_length(w->walls[i].loads.force);
    return sum;
}

/* What a trial changes. */
enum { DEMI_TRY_NORMAL = 1, DEMI_TRY_TANGENT = 2, DEMI_TRY_SAMPLES = 32 };
typedef struct demi_try { const char *name; double step, stiffness; int law; } demi_try;
static const demi_try demi_tries[DEM_TRIALS] = {
    {"as it is",           1,    1,   0},       /* the first */
    {"step doubled",       2,    1,   0},
    {"step halved",        0.5,  1,   0},
    {"step quartered",     0.25, 1,   0},
    {"10 times softer",    1,    0.1, 0},
    {"4 times stiffer",    1,    4,   0},
    {"other normal law",   1,    1,   DEMI_TRY_NORMAL},
    {"other friction law", 1,    1,   DEMI_TRY_TANGENT}};
/* The law that is tried in place of the one in force, -1: none fits. Hertz and linear springs take
   each other's place where there are moduli to make both of; a law of the user's own, or one that
   unloads along another line, has no counterpart. */
static int demi_try_normal(const dem_world *w) {
    int i, j, moduli = 1;
    for (i = 0; i < w->material_count; i++)
        for (j = 0; j < w->material_count; j++)
            moduli &= w->pairs[i*DEMI_MATERIALS + j].given.young_eff > 0;
    if (w->desc.law || !moduli || demi_normal_is(w, DEMI_BRANCHED)) return -1;
    return demi_normal_is(w, DEMI_HERTZIAN) ? DEM_NORMAL_LINEAR : DEM_NORMAL_HERTZ;
}
static int demi_try_tangent(const dem_world *w) {
    int friction, rolling;
    demi_pairs_rub(w, &friction, &rolling);
    if (w->desc.law || !friction || demi_tangent_meant(w) == DEM_TANGENT_NONE) return -1;
    if (demi_tangent_meant(w) != DEM_TANGENT_SPRING) return DEM_TANGENT_SPRING;
    return demi_normal_is(w, DEMI_HERTZIAN) ? DEM_TANGENT_MINDLIN_RESCALED : -1;
}
/* Does the trial make sense in this scene? */
static int demi_try_fits(const dem_world *w, const demi_try *row) {
    if (row->law == DEMI_TRY_NORMAL) return demi_try_normal(w) >= 0;
    if (row->law == DEMI_TRY_TANGENT) return demi_try_tangent(w) >= 0;
    return !w->desc.law || row->stiffness == 1.0;
}
static const char *demi_try_name(const dem_world *w, const demi_try *row) {
    if (row->law == DEMI_TRY_NORMAL)
        return demi_try_normal(w) == DEM_NORMAL_LINEAR ? "linear springs" : "Hertz's law";
    if (row->law == DEMI_TRY_TANGENT)
        return demi_try_tangent(w) == DEM_TANGENT_SPRING ? "friction by a spring"
            : "Mindlin's friction";
    return row->name;
}
/* All moduli and stiffnesses times a factor: of materials, by which steps are chosen, and of pairs,
   by which forces are, since a pair may have been set apart from what it was mixed of. */
static void demi_stiffen(dem_world *t, dem_real factor) {
    int i, j;
    for (i = 0; i < t->material_count; i++) {
        dem_material_desc *m = &t->materials[i];
        m->young *= factor;
        m->stiffness *= factor;
        m->stiffness_unloading *= factor;
        m->stiffness_adhesion *= factor;
    }
    for (i = 0; i < t->material_count; i++)
        for (j = i; j < t->material_count; j++) {
            dem_pair p = t->pairs[i*DEMI_MATERIALS + j].given;
            p.young_eff *= factor;
            p.shear_eff *= factor;
            p.stiffness *= factor;
            p.stiffness_adhesion *= factor;
            p.normal_damping *= DEMI_SQRT(factor);     /* the same share of the critical */
            demi_pair_put(t, i, j, &p);
        }
}
/* Makes a copy what the row says. Its step is as fine for its collisions as that of the scene: a
   share of what is chosen as it goes on, where that is left to the library. */
static void demi_try_set(dem_world *t, const demi_try *row) {
    const double dt = (double)t->clock.dt;
    dem_advice was, is;
    demi_finish(t);
    demi_advise(t, &was);
    if (row->law == DEMI_TRY_NORMAL) t->desc.normal_law = (dem_normal_law)demi_try_normal(t);
    if (row->law == DEMI_TRY_TANGENT) t->desc.tangent_law = (dem_tangent_law)demi_try_tangent(t);
    demi_stiffen(t, (dem_real)row->stiffness);
    demi_advise(t, &is);
    t->dt_share = row->step;
    if (t->desc.dt > 0) {
        t->desc.dt = (dem_real)(dt*row->step);
        if (was.contact_time > 0 && is.contact_time > 0)
            t->desc.dt *= is.contact_time/was.contact_time;
    }
    t->stage.pairs_changed = 1;
    t->stage.dt_valid = t->stage.primed = 0;
}
/* Puts every body a millionth of its radius off: far less than any overlap that matters, and enough
   for chance to show soon, where collisions multiply it, as they do what a trial changes. Less than
   that, the last bit, takes long to grow, and chance would look smaller than it is. */
static void demi_try_shake(dem_world *t, uint64_t seed) {
    int i, k;
    for (i = 0; i < t->bodies.count && seed; i++)
        for (k = 0; k < (t->desc.planar ? 2 : 3) && t->bodies.inv_mass[i] > 0; k++)
            t->bodies.pos[4*i + k] += t->bodies.pos[4*i + 3]*
                (dem_real)(1e-6*(2*demi_uniform(&seed) - 1));
}
/* Runs a copy through the trial; sums the observables' means over its second half. The first is for
   what a change brings with it and is not its steady effect: a heap that sinks a little when it
   becomes softer, and rings a little when stiffer. */
static dem_result demi_try_run(dem_world *t, const dem_trials *all, double *sum) {
    dem_result result = DEM_OK;
    int k, e;
    for (k = 0; k <= DEMI_TRY_SAMPLES && result == DEM_OK; k++) {
        result = dem_world_run(t, all->duration/2/(k ? (int)DEMI_TRY_SAMPLES : 1), 0, 0);
        for (e = 0; e < all->observable_count && k && result == DEM_OK; e++) {
            const dem_observable *o = &all->observables[e];
            const double value = o->function(t, o->user);
            sum[e] += value/(int)DEMI_TRY_SAMPLES;
            if (!demi_finite_double(value))
                result = demi_fail(t, DEM_ERROR_UNSTABLE, "%s is not finite", o->name);
        }
    }
    return result;
}
/* What chance adds to a difference of two means of n runs each, in standard errors: Student's t at
   95 % for 2n - 2 degrees of freedom, by its expansion about the normal law. */
static double demi_student(int n) {
    const double v = 1/(2.0*n - 2);
    return 1.96 + v*(2.372 + v*(2.822 + v*(2.556 + v*1.59)));
}
/* Drifts and promises, once all trials are done. The reference is the smallest step, since that is
   the one choice of which it is known that less is better; whether a softer or stiffer grain is
   the truer one, only the user knows. */
static void demi_trials_judge(dem_trials *out) {
    int i, e;
    for (i = 0; i < out->count; i++)            /* of what came to its end: the smallest step */
        if (out->trial[i].done == out->seeds &&
            out->trial[i].step < out->trial[out->reference].step) out->reference = i;
    for (i = 0; i < out->count; i++) {
        const dem_trial *ref = &out->trial[out->reference];
        dem_trial *t = &out->trial[i];
        t->promise = t->done < out->seeds ? HUGE_VAL : 0;
        for (e = 0; e < out->observable_count && t->done == out->seeds; e++) {
            double scale = out->observables[e].scale, chance;
            if (!(scale > 0)) scale = fabs(ref->value[e]);
            if (!(scale > 0)) scale = DEMI_MAX(fabs(t->value[e]), 1e-300);
            t->drift[e] = (t->value[e] - ref->value[e])/scale;
            chance = demi_student(out->seeds)*sqrt(t->error[e]*t->error[e] +
                                                   ref->error[e]*ref->error[e])/scale;
            t->promise = DEMI_MAX(t->promise, fabs(t->drift[e]) + chance);
        }
    }
}
/* The cheapest that keeps within the tolerance; a tenth less time is worth a change. When none
   does, not even the scene beside itself, chance is larger than what was asked to be seen. */
static void demi_trials_advise(dem_trials *out) {
    const dem_trial *ref = &out->trial[out->reference], *scene = &out->trial[0], *best;
    const double now = scene->seconds;
    int i, found = -1;
    for (i = 0; i < out->count; i++) {
        const dem_trial *t = &out->trial[i];
        if (t->done < out->seeds || t->promise > out->tolerance) continue;
        if (found < 0 || t->seconds < (found ? 1 : 0.9)*out->trial[found].seconds) found = i;
    }
    out->best = found < 0 ? out->reference : found;
    best = &out->trial[out->best];
    if (found < 0)
        snprintf(out->advice, sizeof out->advice, "chance alone moves the observables by up to "
                 "%.2g of their scale, more than the tolerance of %.2g: give a longer duration, "
                 "more seeds, or observables that are averages", ref->promise, out->tolerance);
    else if (!found)
        snprintf(out->advice, sizeof out->advice, "keep the scene as it is: all observables are "
                 "within %.2g of those of \"%s\" (asked: %.2g), and nothing tried is as good in a "
                 "tenth less time", best->promise, ref->name, out->tolerance);
    else if (best->seconds < now)
        snprintf(out->advice, sizeof out->advice, "take \"%s\": all observables are within %.2g of "
                 "those of \"%s\" (asked: %.2g), in %.2g of the time that the scene takes as it is",
                 best->name, best->promise, ref->name, out->tolerance, best->seconds/now);
    else
        snprintf(out->advice, sizeof out->advice, "take \"%s\": as it is the scene is only within "
                 "%.2g of \"%s\" (asked: %.2g); this is within %.2g, in %.2g times the time",
                 best->name, scene->promise, ref->name, out->tolerance, best->promise,
                 best->seconds/now);
}
/* All runs of one trial, each on a copy of its own. A run that is refused or blows up is the
   trial's answer, not the call's: the step may be too large, and that is worth knowing. */
static dem_result demi_trial_run(dem_world *w, const char *state, size_t size, const demi_try *row,
                                 dem_trials *out, dem_trial *trial) {
    double value[16][DEM_OBSERVABLES], wall = 0;
    int e, k;
    memset(value, 0, sizeof value);
    for (k = 0; k < out->seeds && !*trial->refusal; k++) {
        dem_world *t = demi_twin_in_state(w, state, size);
        double begun;
        if (!t) return demi_no_memory(w, "dem_advise");
        demi_try_set(t, row);
        demi_try_shake(t, (uint64_t)k);
        begun = demi_clock();
        if (demi_try_run(t, out, value[k]) == DEM_OK) trial->done++;
        else snprintf(trial->refusal, sizeof trial->refusal, "%.199s", t->error);
        trial->dt = (double)t->clock.dt;
        wall += demi_clock() - begun;
        demi_twin_free(w, t);
    }
    if (trial->done < out->seeds) return DEM_OK;
    trial->seconds = wall/out->seeds/out->duration;
    for (e = 0; e < out->observable_count; e++) {
        double off = 0;
        for (k = 0; k < out->seeds; k++) trial->value[e] += value[k][e]/out->seeds;
        for (k = 0; k < out->seeds; k++)
            off += (value[k][e] - trial->value[e])*(value[k][e] - trial->value[e]);
        trial->error[e] = sqrt(off/(out->seeds - 1.0)/out->seeds);
    }
    return DEM_OK;
}
/* 1 with a sentence when the desc asks for what cannot be. */
static int demi_advise_refuse(dem_world *w, const dem_advise_desc *d) {
    const int lost = demi_body_lost(w);
    int e;
    if (!(d->duration > 0) || !demi_finite_double(d->duration) || !(d->budget >= 0) ||
        !demi_finite_double(d->budget) || !(d->tolerance >= 0) ||
        !demi_finite_double(d->tolerance) || d->seeds < 0 || d->seeds == 1 ||
        d->seeds > 16 || d->observable_count < 0 || d->observable_count > DEM_OBSERVABLES) {
        demi_fail(w, DEM_ERROR_ARGUMENT, "dem_advise: duration is %g s, budget %g s, tolerance %g, "
                  "seeds %d, observables %d; must be > 0, >= 0, >= 0, 2 to 16 (0: 3) and 0 to %d; "
                  "start from DEM_ADVISE_DESC and set duration", d->duration, d->budget,
                  d->tolerance, d->seeds, d->observable_count, (int)DEM_OBSERVABLES);
        return 1;
    }
    for (e = 0; e < d->observable_count; e++)
        if (!d->observables[e].function || !d->observables[e].name) {
            demi_fail(w, DEM_ERROR_ARGUMENT, "dem_advise: observable %d has no function or no "
                      "name; give both, as {\"height\", \"m\", dem_observe_height, 0, 0}", e + 1);
            return 1;
        }
    for (e = 0; e < d->observable_count; e++)
        if (!(d->observables[e].scale >= 0) || !demi_finite_double(d->observables[e].scale)) {
            demi_fail(w, DEM_ERROR_ARGUMENT, "dem_advise: the scale of observable %d is %g, must "
                      "be finite and >= 0; 0 means its own value in the reference", e + 1,
                      d->observables[e].scale);
            return 1;
        }
    if (lost < 0 && w->bodies.count) return 0;
    if (lost < 0)
        demi_fail(w, DEM_ERROR_ARGUMENT, "dem_advise: there are no bodies: nothing to judge by; "
                  "add them, or run until some are fed");
    else
        demi_fail(w, DEM_ERROR_ARGUMENT, "dem_advise: body %u is no longer at a finite place and "
                  "speed: the run has blown up; go back to an earlier checkpoint",
                  (unsigned)w->bodies.slot[lost] + 1);
    return 1;
}
/* What the trials shall simulate so that all end within the budget, from the time of some steps of
   a copy. */
static dem_result demi_advise_plan(dem_world *w, const char *state, size_t size, double budget,
                                   dem_trials *out) {
    dem_world *t = demi_twin_in_state(w, state, size);
    const double asked = out->duration;
    double steps = 0, each, begun;
    int k;
    dem_result result;
    if (!t) return demi_no_memory(w, "dem_advise");
    result = dem_world_step(t, 5);
    begun = demi_clock();
    if (result == DEM_OK) result = dem_world_step(t, 20);
    each = (demi_clock() - begun)/20;
    for (k = 0; k < DEM_TRIALS; k++)
        if (demi_try_fits(w, &demi_tries[k]))
            steps += out->seeds/(double)t->clock.dt/demi_tries[k].step*
                pow(demi_tries[k].stiffness, 0.4);
    if (each*steps*out->duration > budget) out->duration = budget/each/steps;
    if (result != DEM_OK) demi_fail(w, result, "dem_advise: the scene as it is: %.400s", t->error);
    else if (asked < 64*(double)t->clock.dt)
        result = demi_fail(w, DEM_ERROR_ARGUMENT, "dem_advise: duration is %g s, must be at least "
                           "64 steps of %g s; let trials simulate as long as observables need to "
                           "settle", asked, (double)t->clock.dt);
    else if (out->duration < 64*(double)t->clock.dt)
        result = demi_fail(w, DEM_ERROR_ARGUMENT, "dem_advise: %g s of wall time allow for %g s of "
                           "this scene in each trial, must be at least 64 steps of %g s; give more "
                           "budget, fewer seeds, or a smaller part of the scene", budget,
                           out->duration, (double)t->clock.dt);
    demi_twin_free(w, t);
    return result;
}
/* Of the usual observables: the height of the centre of mass above the lowest body; the kinetic
   energy that there is, and what all would gain in falling by their radius. */
static void demi_usual_scales(const dem_world *w, dem_trials *out) {
    const double g = (double)demi_length(w->desc.gravity);
    const dem_vec3 up = g > 0 ? demi_scale(w->desc.gravity, (dem_real)(-1/g)) : demi_v(0, 0, 1);
    double lowest = 1e300, fall = 0;
    int i;
    for (i = 0; i < w->bodies.count; i++) {
        const double r = (double)w->bodies.pos[4*i + 3];
        if (!(w->bodies.inv_mass[i] > 0)) continue;
        lowest = DEMI_MIN(lowest, (double)demi_dot(demi_at(w->bodies.pos + 4*i), up) - r);
        fall += (double)w->bodies.mass[i]*g*r;
    }
    out->observables[0].scale = DEMI_MAX(dem_observe_height(w, 0) - lowest, 0);
    out->observables[1].scale = dem_observe_kinetic(w, 0) + fall;
}
DEM_API dem_result dem_advise(dem_world *w, const dem_advise_desc *d, dem_trials *out) {
    static const dem_observable usual[] = {
        {"height", "m", dem_observe_height, 0, 0}, {"kinetic", "J", dem_observe_kinetic, 0, 0},
        {"contacts", "", dem_observe_contacts, 0, 0}};
    const demi_try *rows[DEM_TRIALS];
    const double begun = demi_clock();
    char *state;
    size_t size;
    dem_result result;
    int k;
    if (demi_null(w, "dem_advise", d, "desc") || demi_null(w, "dem_advise", out, "trials"))
        return DEM_ERROR_ARGUMENT;
    if (demi_unbuilt(w, "dem_advise") != DEM_OK || demi_advise_refuse(w, d))
        return DEM_ERROR_ARGUMENT;
    memset(out, 0, sizeof *out);
    out->duration = d->duration;
    out->tolerance = d->tolerance > 0 ? d->tolerance : 0.02;
    out->seeds = d->seeds ? d->seeds : 3;
    out->observable_count = d->observable_count ? d->observable_count : 3;
    memcpy(out->observables, d->observable_count ? d->observables : usual,
           (size_t)out->observable_count*sizeof *usual);
    if (!d->observable_count) demi_usual_scales(w, out);
    if (!w->facets_valid && !demi_facets_weigh(w)) return demi_no_memory(w, "dem_advise");
    result = demi_dt_settle(w);                 /* refused as a run would be */
    if (result != DEM_OK) return result;
    state = demi_state_keep(w, &size);
    if (!state) return demi_no_memory(w, "dem_advise");
    result = demi_advise_plan(w, state, size, d->budget > 0 ? d->budget : 60, out);
    for (k = 0; k < DEM_TRIALS; k++)
        if (demi_try_fits(w, &demi_tries[k])) rows[out->count++] = &demi_tries[k];
    for (k = 0; k < out->count && result == DEM_OK; k++) {
        dem_trial *trial = &out->trial[k];
        trial->name = demi_try_name(w, rows[k]);
        trial->step = rows[k]->step;
        trial->stiffness = rows[k]->stiffness;
        result = demi_trial_run(w, state, size, rows[k], out, trial);
        if (result == DEM_OK && d->progress &&
            d->progress(w, (k + 1.0)/out->count,
                        (demi_clock() - begun)*(out->count - k - 1)/(k + 1), d->user))
            result = demi_fail(w, DEM_ERROR_STOPPED, "dem_advise: stopped by the progress function "
                               "after %d of %d trials", k + 1, out->count);
    }
    demi_free(w, state);
    if (result != DEM_OK) return result;
    if (out->trial[0].done < out->seeds)
        return demi_fail(w, DEM_ERROR_UNSTABLE, "dem_advise: the scene as it is does not run: "
                         "%.300s", out->trial[0].refusal);
    demi_trials_judge(out);
    demi_trials_advise(out);
    return DEM_OK;
}
DEM_API void dem_trials_print(const dem_trials *t, FILE *out) {
    int i, e;
    if (!t || !out) return;
    fprintf(out, "trials     %d runs each of %.3g s, means of the second half +- their error\n",
            t->seeds, t->duration);
    fprintf(out, "  %-20s %-9s %-9s", "", "dt [s]", "s per s");
    for (e = 0; e < t->observable_count; e++) {
        const dem_observable *o = &t->observables[e];
        char name[64];
        snprintf(name, sizeof name, o->unit && *o->unit ? "%s [%s]" : "%s", o->name, o->unit);
        fprintf(out, " %-22s", name);
    }
    fprintf(out, " within\n");
    for (i = 0; i < t->count; i++) {
        const dem_trial *trial = &t->trial[i];
        fprintf(out, "%c %-20s %-9.3g ", i == t->best ? '*' : ' ', trial->name, trial->dt);
        if (trial->done < t->seeds) { fprintf(out, "%.120s\n", trial->refusal); continue; }
        fprintf(out, "%-9.3g", trial->seconds);
        for (e = 0; e < t->observable_count; e++) {
            char value[64];
            snprintf(value, sizeof value, "%.5g +- %.1g", trial->value[e], trial->error[e]);
            fprintf(out, " %-22s", value);
        }
        fprintf(out, " %.2g%s\n", trial->promise, i == t->reference ? " (reference)" : "");
    }
    fprintf(out, "advice     %s\n", t->advice);
}

/* ---------------------------------------------------------------------------------------------
   >>world
   Making one, taking it down, saying what it does. A world is made of its desc, of which every 0
   is replaced by a choice; the report tells what was chosen and which effects the scene calls
   for, by the same functions that a run asks, on a copy: a report changes nothing. Taking it
   down frees two chains of blocks (demi_hold), so that no array can be forgotten.
   --------------------------------------------------------------------------------------------- */
DEM_API const char *dem_result_name(dem_result r) {
    static const char *names[] = {"ok", "bad argument", "out of memory", "file error",
                                  "bad format", "time step too large",
                                  "unstable", "stopped"};
    return (int)r >= 0 && (size_t)r < sizeof names/sizeof *names ? names[r] : "unknown";
}

DEM_API const char *dem_create_error(const dem_world_desc *d) {
    if (!d) return "dem_world_create: desc is null; give the address of a dem_world_desc that "
        "began as DEM_WORLD_DESC";
    const dem_real lo[3] = {d->domain.lo.x, d->domain.lo.y, d->domain.lo.z};
    const dem_real hi[3] = {d->domain.hi.x, d->domain.hi.y, d->domain.hi.z};
    int k;
    if (!demi_finite3(d->gravity)) return "dem_world_create: gravity is not finite, must be m/s2; "
        "check how it was computed";
    for (k = 0; k < 3; k++) {
        if ((int)d->boundary[k] < 0 || d->boundary[k] > DEM_BOUNDARY_OUTFLOW)
            return "dem_world_create: a boundary is unknown, must be a DEM_BOUNDARY_ value; start "
                "from DEM_WORLD_DESC";
        if (d->boundary[k] != DEM_BOUNDARY_OPEN && (!(hi[k] > lo[k]) || !demi_finite(lo[k]) ||
                                                    !demi_finite(hi[k])))
            return "dem_world_create: a boundary is periodic or outflow, but domain.lo is not "
                "below domain.hi there; set domain";
    }
    if (d->planar && d->boundary[2] != DEM_BOUNDARY_OPEN)
        return "dem_world_create: planar is 1 and the z boundary is not open; discs live at z = 0: "
            "leave it open";
    if (!(d->thickness >= 0) || !demi_finite(d->thickness)) return "dem_world_create: thickness "
        "must be >= 0 m; 0 means 1 m";
    if (!(d->dt >= 0) || !demi_finite(d->dt)) return "dem_world_create: dt must be >= 0 s; 0 lets "
        "the library choose";
    if (!(d->impact_speed >= 0) || !demi_finite(d->impact_speed)) return "dem_world_create: "
        "impact_speed must be >= 0 m/s";
    if (!(d->law_stiffness >= 0) || !demi_finite(d->law_stiffness)) return "dem_world_create: "
        "law_stiffness must be finite and >= 0 N/m; 0 means that of the built-in law";
    if (!demi_finite(d->skin)) return "dem_world_create: skin is not finite; 0 lets the library "
        "choose, below 0 means none";
    if (d->threads < 0 || d->threads > 64) return "dem_world_create: threads must be 0 to 64; 0 "
        "means as many as OpenMP offers";
    if (d->law_memory < 0 || d->law_memory > DEMI_MEMORY) return "dem_world_create: law_memory "
        "must be 0 to 8 reals";
    if (d->law_vectors < 0 || 3*d->law_vectors > d->law_memory)
        return "dem_world_create: law_vectors is more than fits into law_memory, must be at most "
            "law_memory/3";
    if (!demi_law_known(demi_normal_laws, (int)d->normal_law) ||
        !demi_law_known(demi_tangent_laws, (int)d->tangent_law) ||
        !demi_law_known(demi_rolling_laws, (int)d->rolling_law))
        return "dem_world_create: a contact law is unknown, must be one of the enum values; start "
            "from DEM_WORLD_DESC";
    if ((int)d->tension < 0 || d->tension > DEM_TENSION_NONE || (int)d->convention < 0 ||
        d->convention > DEM_CONVENTION_MILL)
        return "dem_world_create: tension or convention is unknown, must be one of the enum "
               "values; start from DEM_WORLD_DESC";
    if ((int)d->friction_load < 0 || d->friction_load > DEM_LOAD_SIZE || (int)d->slider < 0 ||
        d->slider > DEM_SLIDER_REST)
        return "dem_world_create: friction_load or slider is unknown, must be one of the enum "
               "values; start from DEM_WORLD_DESC";
    if ((int)d->integrator < 0 || (int)d->integrator >= DEMI_INTEGRATORS || (int)d->search < 0 ||
        (int)d->search >= DEMI_SEARCHES)
        return "dem_world_create: integrator or search is unknown, must be one of the enum values; "
            "start from DEM_WORLD_DESC";
    if ((int)d->rotation < 0 || d->rotation > DEM_ROTATION_NO_SQUISH ||
        (int)d->ellipsoid_overlap < 0 || d->ellipsoid_overlap > DEM_OVERLAP_NORMAL ||
        (int)d->cluster_contacts < 0 || d->cluster_contacts > DEM_SHARING_NONE)
        return "dem_world_create: rotation, ellipsoid_overlap or cluster_contacts is unknown, must "
            "be one of the enum values; start from DEM_WORLD_DESC";
    if (!d->allocator.alloc_fn != !d->allocator.free_fn)
        return "dem_world_create: the allocator has one of alloc_fn and free_fn; give both or "
            "neither";
    return "";
}

DEM_API dem_world *dem_world_create_checked(const dem_world_desc *desc, int version,
                                            size_t real_size) {
    dem_world *w;
    if (version != DEM_VERSION || real_size != sizeof(dem_real) ||
        *dem_create_error(desc)) return 0;
    w = (dem_world *)demi_raw_alloc(&desc->allocator, sizeof *w);
    if (!w) return 0;
    memset(w, 0, sizeof *w);
    w->desc = w->asked = *desc;
    w->bytes = sizeof *w;
    if (!(w->desc.thickness > 0)) w->desc.thickness = 1;
    if (w->desc.planar) w->desc.gravity.z = 0;
    /* until bodies are there to decide */
    if (w->desc.search == DEM_SEARCH_AUTO) w->desc.search = DEM_SEARCH_GRID;
    if (w->desc.threads == 0) w->desc.threads = DEMI_MIN(demi_threads_available(), 64);
    w->bodies.slot_free = w->bodies.slot_pending = -1;
    w->stage.synced = 1;
    w->bodies.orienting = desc->orientations != 0;
    w->bodies.backward = demi_integrator_rows[desc->integrator].backward;
    w->pairs = (demi_pair *)demi_hold(w, DEMI_SCENE, (size_t)DEMI_MATERIALS*DEMI_MATERIALS,
                                      sizeof(demi_pair));
    w->domains = (demi_domain *)demi_hold(w, DEMI_RUN, DEMI_DOMAINS, sizeof(demi_domain));
    w->cross_incoming_start = (int *)demi_hold(w, DEMI_RUN, DEMI_DOMAINS + 1, sizeof(int));
    if (!w->pairs || !w->domains || !w->cross_incoming_start) {
        dem_world_destroy(w);
        return 0;
    }
    return w;
}

DEM_API void dem_world_destroy(dem_world *w) {
    dem_allocator allocator;
    int chain;
    if (!w) return;
    for (chain = 0; chain < DEMI_CHAINS; chain++) demi_free_chain(w, chain);
    allocator = w->desc.allocator;
    demi_raw_free(&allocator, w, sizeof *w);
}

DEM_API const char *dem_world_error(const dem_world *w) {
    if (!w) return "dem_world_create: the world is null, so it was refused and this call too; "
        "dem_create_error(desc) says why";
    ((dem_world *)w)->refused = 0;              /* somebody looks */
    return w->error;
}
DEM_API dem_world_desc dem_world_desc_get(const dem_world *w) {
    if (!w) return DEM_WORLD_DESC;
    dem_world_desc d = w->desc;
    if (w->clock.dt > 0) d.dt = w->clock.dt;
    d.skin = (dem_real)w->margin.skin;
    return d;
}

/* How many levels there are, of which radii, and why. */
static void demi_levels_report(const dem_world *w, FILE *out) {
    const int auto_ = w->asked.search == DEM_SEARCH_AUTO;
    int i;
    if (w->desc.search == DEM_SEARCH_LEVELS && w->levels.count) {
        fprintf(out, "           %d level%s for radii 1 : %.3g, of up to", w->levels.count,
                w->levels.count == 1 ? "" : "s",
                (double)w->effects.radius_max/DEMI_MAX((double)w->effects.radius_min, 1e-300));
        for (i = 0; i < w->levels.count; i++)
            fprintf(out, "%s %.3g m (%d)", i ? "," : "", w->levels.level[i].radius,
                    w->levels.level[i].count);
        fprintf(out, "\n");
    }
    if (w->levels.tests[0] > 0)
        fprintf(out, "           %s: about %.3g tests per body and search by levels, %.3g on one "
                "grid\n", auto_ ? "chosen" : "by levels or not", w->levels.tests[1],
                w->levels.tests[0]);
}

static int demi_kept_total(const dem_world *w) {
    int d, n = 0;
    for (d = 0; d < w->domain_count; d++) n += w->domains[d].kept;
    return n;
}
/* What a law remembers, in words. */
static const char *demi_law_memory_text(const demi_law_row *row, char text[64]) {
    text[0] = 0;
    if (row->memory)
        snprintf(text, 64, " (%d bytes of memory per near pair)",
                 row->memory*(int)sizeof(dem_real));
    return text;
}
/* The laws in force. Of a law of the user's own only what it was given is known. */
static void demi_laws_report(const dem_world *w, FILE *out) {
    static const char *loads[] = {"the normal force", "its spring's part", "its size"};
    static const char *sliders[] = {"spring and dashpot share it", "the spring alone holds it",
                                    "the spring holds what the dashpot leaves"};
    const int load = w->desc.tension != DEM_TENSION_KEPT ? DEM_LOAD_PUSH
        : (int)w->desc.friction_load;           /* nothing pulls there */
    const demi_laws *laws = &w->laws;
    char text[64];
    const char *unused = "";
#ifdef DEM_LAW
    unused = "; DEM_LAW is named, but desc.law is null, so it does not act here";
#endif
    if (w->desc.law) {
        fprintf(out, "effects    normal, tangential, rolling: your own law; spins and torques are "
                "followed; %d reals of memory per contact\n", w->desc.law_memory);
        return;
    }
    fprintf(out, "effects    normal: %s%s%s%s\n", laws->normal->name,
            w->desc.tension == DEM_TENSION_CLIPPED ? ", tension clipped"
            : w->desc.tension == DEM_TENSION_NONE ? ", no tension" : "",
            demi_law_memory_text(laws->normal, text), unused);
    fprintf(out, "           tangential: %s%s\n", laws->tangent->name, laws->tangent->law
            ? demi_law_memory_text(laws->tangent, text)
            : " (no friction in any pair: no spin, no torque, no memory)");
    if (laws->tangent->law)
        fprintf(out, "           friction's limit is mu times %s; %s\n", loads[load],
                laws->tangent->memory ? sliders[w->desc.slider] : "a dashpot alone holds it");
    fprintf(out, "           rolling: %s%s\n", laws->rolling->name,
            demi_law_memory_text(laws->rolling, text));
}
/* A line about bodies that turn, where there are any. */
static void demi_shapes_report(const dem_world *w, FILE *out) {
    static const char *rotations[] = {"SPIRAL", "Fincham", "NO_SQUISH"};
    static const char *overlaps[] = {"conservative", "[RUB15]'s chord", "along the normal"};
    if (w->bodies.shaped)
        fprintf(out, "           %d bodies are not spheres: rotation by %s; ellipsoids' overlap "
                "%s; a cluster's contacts %s; %.2f contacts per body\n", w->bodies.shaped,
                rotations[w->desc.rotation], overlaps[w->desc.ellipsoid_overlap],
                w->desc.cluster_contacts == DEM_SHARING_ONE ? "are shared" : "add up",
                w->bodies.count ? (double)demi_kept_total(w)/w->bodies.count : 0);
    else if (w->bodies.orienting)
        fprintf(out, "           orientations of spheres are followed, because you asked\n");
}
/* What each wall bears, and what came in and went out. */
static void demi_flows_report(const dem_world *w, FILE *out) {
    int i;
    for (i = 0; i < w->wall_count; i++) {
        const dem_wall_loads *ch = &w->walls[i].loads;
        if (w->walls[i].kind == DEMI_WALL_NONE) continue;
        fprintf(out, "wall %-3d   %d contacts, force (%.4g, %.4g, %.4g) N, axial torque %.4g N m, "
                "power %.4g W\n", i + 1,
                ch->contacts, (double)ch->force.x, (double)ch->force.y, (double)ch->force.z,
                (double)ch->torque_axial,
                (double)ch->power);
    }
    for (i = 0; i < w->feed_count; i++) {
        const dem_feed_state *f = &demi_feed_at(w, i)->state;
        fprintf(out, "feed %-3d   %llu grains, %.6g kg; %llu wait for room%s\n", i + 1,
                (unsigned long long)f->total, f->mass, (unsigned long long)f->waiting,
                f->done ? "; done" : "");
    }
    for (i = 0; i < w->outlet_count; i++) {
        const dem_outlet_state *o = &demi_outlet_at(w, i)->state;
        fprintf(out, "outlet %-3d %llu grains, %.6g kg, of them wanted %llu, %.6g kg\n", i + 1,
                (unsigned long long)o->total, o->total_mass, (unsigned long long)o->sorted,
                o->sorted_mass);
    }
}
/* The account of energy; a residual that is not small says that the step is too large. */
static void demi_ledger_report(const dem_world *w, FILE *out) {
    const dem_ledger l = dem_ledger_get(w);
    fprintf(out, "ledger [J] in: gravity %.6g, walls %.6g, field %.6g, inserted %.6g, removed "
            "%.6g\n           stored: kinetic %.6g, rotational %.6g, elastic %.6g\n"
            "           lost: normal %.6g, sliding %.6g, tangential %.6g, rolling %.6g\n"
            "           residual %.3g (%.2g of the throughput)\n", l.gravity, l.walls, l.force,
            l.inserted, l.removed, l.kinetic, l.rotational, l.elastic, l.normal, l.slide, l.tangent,
            l.rolling, l.residual, l.throughput > 0 ? l.residual/l.throughput : 0);
}
DEM_API void dem_world_report(const dem_world *world, FILE *out) {
    if (demi_null(world, "dem_world_report", out, "out")) return;
    dem_world look = *world, *w = &look;        /* effects not yet worked out are so in a copy */
    const dem_counters c = dem_counters_get(w);
    const double per = w->bodies.count ? 1.0/w->bodies.count : 0;
    dem_advice a;
    if (!w->stage.list_valid) { demi_effects(w); demi_levels_choose(w); }
    demi_advise(w, &a);
    fprintf(out, "dem.h %d.%d.%d, %s precision, %d thread%s, %d domain%s, %.1f MB\n",
            DEM_VERSION_MAJOR, DEM_VERSION_MINOR,
            DEM_VERSION_PATCH, DEMI_SINGLE ? "single" : "double", c.threads, c.threads == 1 ? ""
            : "s", c.domains,
            c.domains == 1 ? "" : "s", (double)c.memory/1e6);
    fprintf(out, "bodies     %d of radius %g to %g m; %llu inserted = %llu present + %llu removed "
            "+ %llu left\n", w->bodies.count,
            (double)w->effects.radius_min, (double)w->effects.radius_max,
                (unsigned long long)w->bodies.balance.inserted,
            (unsigned long long)w->bodies.balance.present,
                (unsigned long long)w->bodies.balance.removed,
            (unsigned long long)w->bodies.balance.left);
    fprintf(out, "time       %g s in %llu steps of %g s by %s (order %d)\n", w->clock.time,
            (unsigned long long)w->clock.steps, (double)w->clock.dt,
            demi_integrator_rows[w->desc.integrator].name,
            demi_integrator_rows[w->desc.integrator].order);
    fprintf(out, "time step  t_c %.4g s, t_c/dt %.1f, limit t_c/20 = %.4g s; Rayleigh %.4g s; "
            "bound by %s\n", (double)a.contact_time,
            w->clock.dt > 0 ? (double)a.contact_time/(double)w->clock.dt : 0, (double)a.dt_max,
            (double)a.rayleigh, a.binds);
    fprintf(out, "search     %s, skin %.3g m, %llu rebuilds, %.1f steps each; per body %.2f "
            "candidates, %.2f contacts\n",
            demi_searches[w->desc.search].name, w->margin.skin,
                (unsigned long long)w->clock.rebuilds,
                w->clock.rebuilds
            ? (double)w->clock.steps/(double)w->clock.rebuilds : 0,
            per*c.candidates, per*c.contacts);
    demi_levels_report(w, out);
    demi_laws_report(w, out);
    demi_shapes_report(w, out);
    fprintf(out, "           bodies %s; walls %d; force field %s; ledger %s; kernel: %s\n",
            w->effects.uniform ? "all alike (coefficients once)" : demi_many_species(w)
                ? "differ (coefficients per near pair)"
                : "of few species (coefficients once for each two)", w->wall_count,
            w->desc.force || w->desc.body_force ? "yes" : "no", w->desc.ledger ? "on" : "off",
            demi_kernel_choose(w));
    fprintf(out, "overlap    %.3g of the radius at most so far%s\n", w->booked.overlap_max,
            w->booked.overlap_max > 0.05 ? "  (beyond .05: stiffen the material or slow down)"
                : "");
    dem_pairs_print(w, out);
    demi_flows_report(w, out);
    if (w->desc.ledger) demi_ledger_report(w, out);
}

/* ---------------------------------------------------------------------------------------------
   >>slabs
   Spatial decomposition along one axis, after [ALK07] 3.5. Each slab is a world of its own: the
   walls of the scene, its own grains, and copies of those grains of its lower neighbour that may
   touch them: its ghosts. Slots are those of the whole scene, so that contact memory, filed by
   slot, finds its pair in any slab. One step:
       move     own grains; ghosts stand still
       decide   a new list? a new near list? one maximum over all slabs
       send up  state of the grains that are ghosts in the upper neighbour
       respond  own - own, own - ghost, own - wall; ghost - ghost belongs to the owner
       return   forces on ghosts go down to their owners, who add them
   [ALK07] sends copies down; up is the mirror image. At a rebuild grains that crossed a border
   migrate, with a copy of every entry of contact memory that names them: so whichever slab computes
   a pair next has its memory. (It is the upper of the pair's two homes; the pair was computed where
   one of them was, and that one either stays or passes through.) Then ghosts are chosen anew.
   A slab is never thinner than two grains and the skin, so that only neighbours touch.

   Work is done in phases: one function per slab, all slabs of this process in demi_parallel; a
   phase writes only to its own slab and reads its neighbours' outboxes, which rest meanwhile.
   Between phases outboxes that lead to other processes are exchanged. What is reduced over
   processes is maxima, and sums of whole numbers, which are exact in any order: so bits hang on the
   number of slabs alone, not on threads or processes.

   All slabs but the first of a process see walls that never move by themselves: the poses are
   copied, so that a motion of the user's own is called as often as ever.
   --------------------------------------------------------------------------------------------- */
enum { DEMI_SLABS = 1024, DEMI_SLAB_BINS = 32, DEMI_UP = 1, DEMI_DOWN = 2, DEMI_ALL = 0,
       DEMI_GHOST = 1, DEMI_GOES_DOWN = 2, DEMI_GOES_UP = 3, DEMI_GHOST_ABOVE = 4 };

/* A message: bytes that grow. */
typedef struct demi_message { char *bytes; size_t size; } demi_message;

typedef struct demi_slab {
    dem_world *world;
    int index;                     /* among all */
    dem_result result;             /* of the last phases; looked at by demi_slabs_agree */
    demi_message out[2];            /* to the lower, to the upper neighbour */
    demi_message in[2];             /* from them, when they are in another process */
    int32_t *lent, *ghost;         /* indices of own grains that are ghosts above; of ghosts here */
    dem_real *ghost_inv;           /* x 2: 1/mass, 1/inertia of ghosts */
    int32_t *add;                  /* see demi_pairs_unpack */
    int lent_count, ghost_count, leavers;
    uint64_t bytes, migrated;
    double work, seconds;
    double press_limit;            /* s, of the body that is pressed most: press_worst */
    int press_worst;
    demi_crowd crowd;              /* who is near the region of a feed */
} demi_slab;

/* The head is a world without grains of its own: it holds what the slabs have in common (time,
   step, skin, errors), and lends itself to functions that ask a world for totals. It has the feeds,
   too: every process draws for all slabs, and so all draw the same. It comes first, so that a task
   finds its slabs. */
struct dem_slabs {
    dem_world head;
    dem_slabs_desc desc;
    int axis, count, first, local, ring, broken;
    double period, cut;            /* m: along the axis; thinnest slab there may be */
    double *borders;               /* count + 1 */
    double *values;                /* for reductions: value_room */
    size_t value_room;
    demi_slab *slabs;              /* local */
    demi_domain total;             /* the head's only domain */
    demi_message mine, all;         /* for dem_slabs_collect */
    uint32_t *known;               /* by slot: generation of the body dealt or fed, 0: none */
    int dealt, told, slots;        /* how many slots: dealt, known to the world, there are */
    uint64_t border_moves;
    void (*phase)(struct dem_slabs *s, demi_slab *b);
};

/* --- messages --- */

/* Appends bytes. 0 when memory ran out; what was there stays. */
static int demi_message_put(dem_world *w, demi_message *p, const void *data, size_t size) {
    if (!DEMI_GROW(w, p->bytes, p->size + size)) return 0;
    if (size) memcpy(p->bytes + p->size, data, size);
    p->size += size;
    return 1;
}
static void demi_unpack(const char **from, void *to, size_t size) {
    if (!size) return;                          /* of a message that is not there, too */
    memcpy(to, *from, size);
    *from += size;
}

/* --- a grain in a message: all it keeps, the rows of demi_body_arrays one after the other, its
       slot first --- */

/* Body i, its places moved by `shift` along axis. 0 when memory ran out. */
static int demi_grain_put(dem_world *host, demi_message *out, const dem_world *w, int i, int axis,
                          dem_real shift) {
    int k;
    for (k = 0; k < DEMI_BODY_ARRAYS; k++) {
        const demi_body_array *a = &demi_body_arrays[k];
        dem_real place[4];
        if (!demi_keeps(w, a)) continue;
        if (a->what != DEMI_PLACES) {
            if (!demi_message_put(host, out, demi_datum(w, a, i), a->item)) return 0;
            continue;
        }
        memcpy(place, demi_datum(w, a, i), sizeof place);
        place[axis] += shift;
        if (!demi_message_put(host, out, place, sizeof place)) return 0;
    }
    return 1;
}
/* Body i becomes the one that arrived. */
static void demi_grain_unpack(dem_world *w, int i, const char **from) {
    int k;
    for (k = 0; k < DEMI_BODY_ARRAYS; k++) {
        const demi_body_array *a = &demi_body_arrays[k];
        if (demi_keeps(w, a))
            demi_unpack(from, demi_datum(w, a, i), a->item);
    }
}
static uint32_t demi_grain_slot(const char *from) {
    uint32_t slot;
    memcpy(&slot, from, sizeof slot);
    return slot;
}
/* Room has been seen to. Answers its index. */
static int demi_grain_append(dem_world *w, const char **from) {
    const int i = w->bodies.count++;
    demi_grain_unpack(w, i, from);
    w->bodies.slot_index[w->bodies.slot[i]] = i;
    if (demi_shape_of(w, i)) w->bodies.shaped++;
    w->lll_valid = 0;
    return i;
}
/* Takes a grain out of a slab without its having left the scene. */
static void demi_grain_forget(dem_world *w, int i) {
    const int slot = (int)w->bodies.slot[i], pending = w->bodies.slot_pending;
    const double removed = w->booked.removed;
    demi_body_take_out(w, i);
    w->bodies.slot_pending = pending;
    w->bodies.slot_index[slot] = -1;
    w->bodies.slot_generation[slot]--;
    w->booked.removed = removed;
    w->bodies.ghost[slot] = 0;
}

/* Grains whose mark is `mark`; with them, when asked, the filed memory of pairs that name one of
   them, their contacts that are kept (all there are, for mark DEMI_ALL).
   shift: added along axis. Memory must be filed: after demi_list_drop or demi_carry_collect. */
typedef struct demi_message_head {
    int32_t grains, pairs, contacts, stride;
} demi_message_head;
static int demi_pack(dem_world *host, const dem_world *w, const uint8_t *marks, int mark,
                     int memory, int axis, dem_real shift, demi_message *out) {
    const size_t start = out->size;
    const int stride = w->filed.stride;
    demi_message_head head = {0, 0, 0, 0};
    int i, k, d, ok = demi_message_put(host, out, &head, sizeof head);
    head.stride = stride;
    for (i = 0; i < w->bodies.count && ok; i++) {
        if (marks[w->bodies.slot[i]] != mark) continue;
        ok = demi_grain_put(host, out, w, i, axis, shift);
        head.grains++;
    }
    for (i = 0; memory && w->filed.count && i < w->filed.rows && ok; i++)
        for (k = w->filed.start[i]; k < w->filed.start[i + 1] && ok; k++) {
            const int32_t p = w->filed.partner[k], other = p < 0 ? ~p : p, row = i;
            if (mark != DEMI_ALL && marks[row] != mark && marks[other] != mark) continue;
            ok = demi_message_put(host, out, &row, sizeof row) &&
                 demi_message_put(host, out, &p, sizeof p) &&
                 demi_message_put(host, out, w->filed.memory + (size_t)k*(size_t)stride,
                                 (size_t)stride*sizeof(dem_real));
            head.pairs++;
        }
    for (d = 0; memory && d < DEMI_DOMAINS && ok; d++)
        for (k = 0; k < w->domains[d].kept && ok; k++) {
            demi_kept c = demi_kept_of(w, d)[k];
            if (w->stage.list_valid) {
                c.a = (int32_t)w->bodies.slot[c.a];
                if (c.b >= 0) c.b = (int32_t)w->bodies.slot[c.b];
            }
            if (mark != DEMI_ALL && marks[c.a] != mark && (c.b < 0 || marks[c.b] != mark)) continue;
            ok = demi_message_put(host, out, &c, sizeof c);
            head.contacts++;
        }
    if (ok) memcpy(out->bytes + start, &head, sizeof head);
    return ok;
}

/* Room for what is to arrive by these heads, beside what is filed already; `add` for
   demi_pairs_unpack. Contacts that are there move to the first domain. 0 when memory ran out. */
static int demi_filed_reserve(dem_world *w, int32_t **add, const demi_message_head *come) {
    const int had = w->filed.count, rows = w->bodies.slot_count;
    int d, total = 0;
    demi_kept *to;
    for (d = 0; d < DEMI_DOMAINS; d++) total += w->domains[d].kept;
    if (!demi_carry_reserve(w, rows, had + come->pairs, come->stride) ||
        !DEMI_GROW(w, *add, (size_t)rows + 1) ||
        !DEMI_GROW(w, w->kept_now, (size_t)(total + come->contacts)))
        return 0;
    if (!had) memset(w->filed.start, 0, ((size_t)rows + 2)*sizeof(int32_t));
    for (d = had ? w->filed.rows : rows; d < rows; d++) w->filed.start[d + 1] = w->filed.start[d];
    w->filed.rows = rows;
    w->filed.stride = come->stride;
    to = w->kept_now;
    for (d = 0; d < DEMI_DOMAINS; d++) {
        demi_domain *o = &w->domains[d];
        if (o->kept && d)
            memmove(to, demi_kept_of(w, d),
                    (size_t)o->kept*sizeof *to);
        to += o->kept;
        o->kept = 0;
    }
    w->domains[0].kept = total;
    for (d = 1; d <= DEMI_DOMAINS; d++) w->kept_first[d] = total + come->contacts;
    return 1;
}
/* Files pairs that arrived behind those already in their rows. */
static void demi_pairs_unpack(dem_world *w, int32_t *add, const char *from, int pairs) {
    const size_t per = (size_t)w->filed.stride*sizeof(dem_real), item = 2*sizeof(int32_t) + per;
    int32_t *start = w->filed.start, row, shift = pairs;
    int k;
    if (!pairs) return;
    memset(add, 0, ((size_t)w->filed.rows + 1)*sizeof(int32_t));
    for (k = 0; k < pairs; k++) {
        memcpy(&row, from + (size_t)k*item, sizeof row);
        add[row]++;
    }
    for (row = w->filed.rows - 1; row >= 0; row--) {          /* make gaps, from the far end on */
        const int32_t begin = start[row], n = start[row + 1] - begin;
        start[row + 1] += shift;
        shift -= add[row];
        if (!n || !shift) continue;
        memmove(w->filed.partner + begin + shift, w->filed.partner + begin,
                (size_t)n*sizeof(int32_t));
        memmove(w->filed.memory + (size_t)(begin + shift)*(size_t)w->filed.stride,
                w->filed.memory + (size_t)begin*(size_t)w->filed.stride, (size_t)n*per);
    }
    for (k = 0; k < pairs; k++) {
        int32_t to;
        demi_unpack(&from, &row, sizeof row);
        to = start[row + 1] - add[row]--;
        demi_unpack(&from, &w->filed.partner[to], sizeof(int32_t));
        demi_unpack(&from, w->filed.memory + (size_t)to*(size_t)w->filed.stride, per);
    }
    w->filed.count += pairs;
}
/* What a message has besides grains, which end at `from`: files all of it. */
static void demi_filed_unpack(dem_world *w, int32_t *add, const demi_message_head *h,
                            const char *from) {
    demi_domain *first = &w->domains[0];
    if (!h->pairs && !h->contacts) return;
    demi_pairs_unpack(w, add, from, h->pairs);
    from += (size_t)h->pairs*(2*sizeof(int32_t) + (size_t)h->stride*sizeof(dem_real));
    if (h->contacts)
        demi_unpack(&from, w->kept_now + first->kept, (size_t)h->contacts*sizeof(demi_kept));
    first->kept += h->contacts;
}

/* ---------------------------------------------------------------------------------------------
   >>slabs-step
   One step of all slabs: phases, what goes to neighbours, what is agreed on, new lists, borders.
   --------------------------------------------------------------------------------------------- */

/* One slab's share of a phase, timed. */
static void demi_slab_task(dem_world *w, int k) {
    dem_slabs *s = (dem_slabs *)(void *)w;      /* the head comes first */
    const double begun = demi_clock();
    s->phase(s, &s->slabs[k]);
    s->slabs[k].seconds += demi_clock() - begun;
}
static void demi_slabs_phase(dem_slabs *s, void (*phase)(dem_slabs *, demi_slab *)) {
    s->phase = phase;
    demi_parallel(&s->head, s->head.desc.threads, s->local, demi_slab_task);
}

/* Is there a slab above (side 1) or below (side 0)? */
static int demi_slab_has(const dem_slabs *s, const demi_slab *b, int side) {
    return s->ring || (side ? b->index + 1 < s->count : b->index > 0);
}
/* What the neighbour on one side sent here. */
static const demi_message *demi_slab_inbox(const dem_slabs *s, const demi_slab *b, int side) {
    int k = b->index - s->first + (side ? 1 : -1);
    if (s->local == s->count) k = (k + s->count)%s->count;
    return k >= 0 && k < s->local ? &s->slabs[k].out[!side] : &b->in[side];
}

/* From here on processes may differ: nothing but collecting from elsewhere makes sense. */
static dem_result demi_slabs_transport_failed(dem_slabs *s, const char *what, int answer) {
    s->broken = 1;
    return demi_fail(&s->head, DEM_ERROR_STOPPED, "dem_slabs_step: the transport's %s answered %d, "
                     "must be 0; the slabs cannot go on: mend the connection and create them anew "
                     "from the last collected world or checkpoint", what, answer);
}
/* Maxima over processes, or sums, which are of whole numbers. */
static dem_result demi_slabs_reduce(dem_slabs *s, double *values, int count, int sum) {
    int answer;
    if (s->local == s->count) return DEM_OK;
    answer = s->desc.transport.reduce_fn(values, count, sum, s->desc.transport.user);
    return answer ? demi_slabs_transport_failed(s, "reduce_fn", answer) : DEM_OK;
}

/* Looks at the results of the last phases. When one is bad, all processes return it; the sentence
   is that of the lowest slab concerned. flags (count): replaced by their maxima over processes. */
static dem_result demi_slabs_agree(dem_slabs *s, double *flags, int count) {
    double v[8] = {0, 0, 0, 0, 0, 0, 0, 0};
    dem_result result;
    int k, index;
    for (k = 0; k < s->local; k++) {
        demi_slab *b = &s->slabs[k];
        if (b->result == DEM_OK) continue;
        v[0] = DEMI_MAX(v[0], (s->count - b->index)*16.0 + (double)b->result);
    }
    for (k = 0; k < count; k++) v[1 + k] = flags[k];
    result = demi_slabs_reduce(s, v, 1 + count, 0);
    if (result != DEM_OK) return result;
    for (k = 0; k < count; k++) flags[k] = v[1 + k];
    for (k = 0; k < s->local; k++) s->slabs[k].result = DEM_OK;
    if (!(v[0] > 0)) return DEM_OK;
    index = s->count - (int)v[0]/16;
    result = (dem_result)((int)v[0]%16);
    if (index >= s->first && index < s->first + s->local)
        return demi_fail(&s->head, result, "dem_slabs_step: slab %d: %.440s", index,
                         s->slabs[index - s->first].world->error);
    return demi_fail(&s->head, result, "dem_slabs_step: slab %d stopped: %s; the process that "
                     "holds it has the sentence", index, dem_result_name(result));
}

/* Outboxes that lead to other processes, up, down or both ways. Sizes are told first unless both
   ends know them. */
static dem_result demi_slabs_exchange(dem_slabs *s, int ways, int sized) {
    demi_slab *low = &s->slabs[0], *top = &s->slabs[s->local - 1];
    const dem_transport *t = &s->desc.transport;
    uint64_t send[2] = {0, 0}, get[2] = {0, 0};
    dem_result result;
    int k, answer;
    for (k = 0; k < s->local; k++) {
        demi_slab *b = &s->slabs[k];
        if (ways & DEMI_DOWN && demi_slab_has(s, b, 0)) b->bytes += b->out[0].size;
        if (ways & DEMI_UP && demi_slab_has(s, b, 1)) b->bytes += b->out[1].size;
    }
    if (s->local == s->count) return DEM_OK;
    if (ways & DEMI_DOWN) send[0] = low->out[0].size;
    if (ways & DEMI_UP) send[1] = top->out[1].size;
    if (sized) {
        if (ways & DEMI_DOWN) get[1] = top->in[1].size;
        if (ways & DEMI_UP) get[0] = low->in[0].size;
    } else {
        answer = t->exchange_fn(&send[0], 8, &get[0], 8, &send[1], 8, &get[1], 8, t->user);
        if (answer) return demi_slabs_transport_failed(s, "exchange_fn", answer);
        if (!DEMI_GROW(low->world, low->in[0].bytes, (size_t)get[0]) ||
            !DEMI_GROW(top->world, top->in[1].bytes, (size_t)get[1]))
            low->result = demi_no_memory(low->world, "dem_slabs_step");
        result = demi_slabs_agree(s, 0, 0);
        if (result != DEM_OK) return result;
        low->in[0].size = (size_t)get[0];
        top->in[1].size = (size_t)get[1];
    }
    answer = t->exchange_fn(low->out[0].bytes, (size_t)send[0],
                            low->in[0].bytes, (size_t)get[0],
                            top->out[1].bytes, (size_t)send[1],
                            top->in[1].bytes, (size_t)get[1], t->user);
    return answer ? demi_slabs_transport_failed(s, "exchange_fn", answer) : DEM_OK;
}

/* --- borders --- */

/* Borders that share the weight in `bins` (n of them over lo..hi) out evenly. */
static void demi_slabs_lay(dem_slabs *s, const double *bins, int n, double lo, double hi) {
    double total = 0, sum = 0;
    int i, j = 1;
    for (i = 0; i < n; i++) total += bins[i];
    for (i = 0; i < n; i++) {
        for (; j < s->count && bins[i] > 0 && sum + bins[i] >= total*j/s->count; j++)
            s->borders[j] = lo + (hi - lo)*(i + (total*j/s->count - sum)/bins[i])/n;
        sum += bins[i];
    }
    for (; j < s->count; j++) s->borders[j] = hi;
}
/* No slab thinner than the cut. Outermost slabs of an open axis have no end. */
static void demi_slabs_space(dem_slabs *s) {
    double *b = s->borders;
    int j;
    for (j = s->ring ? 1 : 2; j < s->count; j++) b[j] = DEMI_MAX(b[j], b[j - 1] + s->cut);
    for (j = s->count - 1; s->ring && j > 0; j--) b[j] = DEMI_MIN(b[j], b[j + 1] - s->cut);
}
/* Adds a slab's own grains to bins. */
static void demi_slabs_bin(const dem_slabs *s, const dem_world *w, double weight, double *bins,
                           int n, double lo, double hi) {
    int i;
    for (i = 0; i < w->bodies.count; i++) {
        const double t = ((double)w->bodies.pos[4*i + s->axis] - lo)/(hi - lo)*n;
        if (!demi_is_ghost(w, i)) bins[t > 0 ? t < n ? (int)t : n - 1 : 0] += weight;
    }
}
/* The highest place of its own grains, and minus the lowest: one reduction finds both. */
static void demi_slabs_extent(const dem_slabs *s, const dem_world *w, double *ends) {
    int i;
    for (i = 0; i < w->bodies.count; i++) {
        const double x = (double)w->bodies.pos[4*i + s->axis];
        if (demi_is_ghost(w, i)) continue;
        ends[0] = DEMI_MAX(ends[0], x);
        ends[1] = DEMI_MAX(ends[1], -x);
    }
}
/* Moves the borders when counted work is shared too unevenly: each grain weighs what a grain of its
   slab costs on average, in whole numbers, so that sums are the same in any order. */
static dem_result demi_slabs_balance(dem_slabs *s) {
    const int n = DEMI_SLAB_BINS*s->count;
    const int every = s->desc.balance_interval > 0 ? s->desc.balance_interval : 8;
    const double limit = s->desc.balance > 0 ? (double)s->desc.balance : 1.1;
    double *v = s->values, ends[2] = {-1e300, -1e300}, most = 0, total = 0;
    dem_result result;
    int k;
    if (s->desc.balance < 0 || s->head.clock.rebuilds == 0 ||
        s->head.clock.rebuilds%(uint64_t)every)
        return DEM_OK;
    for (k = 0; k < s->count; k++) v[k] = 0;
    for (k = 0; k < s->local; k++) v[s->first + k] = s->slabs[k].work;
    result = demi_slabs_reduce(s, v, s->count, 0);
    for (k = 0; k < s->count; k++) { total += v[k]; most = DEMI_MAX(most, v[k]); }
    if (result != DEM_OK || !(most*s->count > limit*total)) return result;
    for (k = 0; k < s->local; k++) demi_slabs_extent(s, s->slabs[k].world, ends);
    result = demi_slabs_reduce(s, ends, 2, 0);
    if (result != DEM_OK || !(ends[0] > -ends[1])) return result;
    if (s->ring) { ends[0] = s->borders[s->count]; ends[1] = -s->borders[0]; }
    for (k = 0; k < n; k++) v[k] = 0;
    for (k = 0; k < s->local; k++) {
        const dem_world *w = s->slabs[k].world;
        const int home = w->bodies.count - s->slabs[k].ghost_count;
        const double each = home > 0 ? floor(16*s->slabs[k].work/home + 0.5) : 1;
        demi_slabs_bin(s, w, DEMI_MAX(each, 1), v, n, -ends[1], ends[0]);
    }
    result = demi_slabs_reduce(s, v, n, 1);
    if (result != DEM_OK) return result;
    demi_slabs_lay(s, v, n, -ends[1], ends[0]);
    s->border_moves++;
    return DEM_OK;
}

/* The skin of a rebuild, by the model that serves a single world, from totals over all slabs; and
   with it the thinnest slab there may be. */
static dem_result demi_slabs_skin(dem_slabs *s) {
    double sums[3] = {0, 0, 0}, radii[3] = {0, -1e300, 0};    /* largest, -smallest; near_span */
    dem_world *h = &s->head;
    dem_result result;
    int k, i, d;
    for (k = 0; k < s->local; k++) {
        const dem_world *w = s->slabs[k].world;
        radii[2] = DEMI_MAX(radii[2], w->margin.span);
        for (d = 0; d < w->domain_count; d++) {
            sums[0] += w->domains[d].own + w->domains[d].cross;
            sums[1] += w->domains[d].contacts;
        }
        for (i = 0; i < w->bodies.count; i++) {
            const double r = (double)w->bodies.pos[4*i + 3];
            if (demi_is_ghost(w, i)) continue;
            sums[2]++;
            radii[0] = DEMI_MAX(radii[0], r);
            radii[1] = DEMI_MAX(radii[1], -r);
        }
    }
    result = demi_slabs_reduce(s, sums, 3, 1);
    if (result == DEM_OK) result = demi_slabs_reduce(s, radii, 3, 0);
    if (result != DEM_OK) return result;
    h->domain_count = 1;
    s->total.own = (int)DEMI_MIN(sums[0], (double)INT_MAX);
    s->total.contacts = (int)DEMI_MIN(sums[1], (double)INT_MAX);
    h->bodies.count = (int)sums[2];
    h->effects.radius_max = (dem_real)radii[0];
    h->effects.radius_min = (dem_real)(h->bodies.count ? -radii[1] : 0);
    h->margin.span = radii[2];
    demi_skin_choose(h);
    if (s->ring && h->desc.skin >= 0 && h->desc.skin <= 0) {
        const double room = s->period/s->count/(1 + 2e-6) - 2*radii[0];
        if (room > 0) h->margin.skin = h->margin.skin_auto = DEMI_MIN(h->margin.skin, room);
    }
    h->margin.skin = (double)(dem_real)h->margin.skin;        /* as the slabs get it */
    s->cut = (2*radii[0] + h->margin.skin)*(1 + 1e-6); /* rounding must not cost a ghost */
    if (s->ring && s->cut*s->count > s->period)
        return demi_fail(h, DEM_ERROR_ARGUMENT, "dem_slabs_step: %d slabs in a period of %g m are "
                         "%g m thick, must be at least %g m (two grains and the skin); use at most "
                         "%d slabs or a smaller skin", s->count, s->period, s->period/s->count,
                         s->cut, (int)(s->period/s->cut));
    return DEM_OK;
}

/* --- a rebuild, phase by phase --- */

/* Memory is filed, ghosts are dropped. */
static void demi_slab_drop(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    int i;
    (void)s;
    if (!demi_list_drop(w)) { b->result = demi_no_memory(w, "dem_slabs_step"); return; }
    for (i = w->bodies.count - 1; i >= 0; i--) if (demi_is_ghost(w, i)) demi_grain_forget(w, i);
    b->ghost_count = b->lent_count = 0;
}
/* Where a grain belongs: -1 below, 0 here, 1 above; *shift: what its position changes by on the
   way. A grain that a whole period would put back on the same border stays. */
static int demi_slab_side(const dem_slabs *s, const demi_slab *b, dem_real x, dem_real *shift) {
    const dem_real period = (dem_real)s->period;
    *shift = 0;
    if ((double)x < s->borders[b->index]) {
        if (b->index == 0) *shift = period;
        return b->index == 0 && (double)(x + period) >= s->borders[s->count] ? 0 : -1;
    }
    if ((double)x >= s->borders[b->index + 1]) {
        if (b->index == s->count - 1) *shift = -period;
        return 1;
    }
    return 0;
}
static dem_real demi_slab_shift(const dem_slabs *s, const demi_slab *b, int side) {
    if (side && b->index == s->count - 1) return -(dem_real)s->period;
    return !side && b->index == 0 ? (dem_real)s->period : 0;
}
/* Those that crossed a border go into the outboxes; they stay here until there is room for them. */
static void demi_slab_leave(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    dem_real shift;
    int i, side, ok = 1, going[2] = {0, 0};
    for (i = 0; i < w->bodies.count; i++) {
        side = demi_slab_side(s, b, w->bodies.pos[4*i + s->axis], &shift);
        if (!side) continue;
        w->bodies.ghost[w->bodies.slot[i]] = side < 0 ? DEMI_GOES_DOWN : DEMI_GOES_UP;
        going[side > 0]++;
    }
    b->leavers = going[0] + going[1];
    for (side = 0; side < 2; side++) {
        b->out[side].size = 0;
        ok = ok && demi_pack(w, w, w->bodies.ghost, side ? DEMI_GOES_UP : DEMI_GOES_DOWN,
                             going[side] > 0, s->axis, demi_slab_shift(s, b, side), &b->out[side]);
    }
    for (i = 0; b->leavers && i < w->bodies.count; i++) w->bodies.ghost[w->bodies.slot[i]] = 0;
    if (!ok) b->result = demi_no_memory(w, "dem_slabs_step");
}
/* What a neighbour sent, in numbers, and where its grains begin; zeros where there is none. */
static demi_message_head demi_slab_head(const dem_slabs *s, const demi_slab *b, int side,
                                       const char **grains) {
    demi_message_head head = {0, 0, 0, 0};
    if (demi_slab_has(s, b, side)) {
        *grains = demi_slab_inbox(s, b, side)->bytes;
        demi_unpack(grains, &head, sizeof head);
    }
    return head;
}
/* Room for all that arrives from both sides, before anything leaves. */
static void demi_slab_room(dem_slabs *s, demi_slab *b) {
    const char *from = 0;
    const demi_message_head l = demi_slab_head(s, b, 0, &from);
    const demi_message_head u = demi_slab_head(s, b, 1, &from);
    dem_world *w = b->world;
    demi_message_head come = {l.grains + u.grains, l.pairs + u.pairs, l.contacts + u.contacts, 0};
    come.stride = l.pairs ? l.stride : u.pairs ? u.stride : w->filed.stride;
    if (!demi_bodies_reserve(w, (size_t)w->bodies.count + (size_t)come.grains) ||
        !demi_filed_reserve(w, &b->add, &come))
        b->result = demi_no_memory(w, "dem_slabs_step");
}
/* Leavers go, arrivals come in: nothing can fail any more. */
static void demi_slab_migrate(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    dem_real shift;
    int i, side;
    for (i = w->bodies.count - 1; i >= 0; i--)
        if (demi_slab_side(s, b, w->bodies.pos[4*i + s->axis], &shift)) demi_grain_forget(w, i);
    b->migrated += (uint64_t)b->leavers;
    for (side = 0; side < 2; side++) {
        const char *from = 0;
        const demi_message_head h = demi_slab_head(s, b, side, &from);
        for (i = 0; i < h.grains; i++) demi_grain_append(w, &from);
        demi_filed_unpack(w, b->add, &h, from);
    }
}
/* Grains near enough to the upper border to touch something beyond it. */
static void demi_slab_invite(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    int i, n = 0;
    b->out[1].size = 0;
    if (!demi_slab_has(s, b, 1)) return;
    if (!DEMI_GROW(w, b->lent, (size_t)w->bodies.count)) {
        b->result = demi_no_memory(w, "dem_slabs_step");
        return;
    }
    for (i = 0; i < w->bodies.count; i++) {
        const double x = (double)w->bodies.pos[4*i + s->axis], r = (double)w->bodies.pos[4*i + 3];
        if (!(x + s->cut - (double)s->head.effects.radius_max +
              r > s->borders[b->index + 1])) continue;
        w->bodies.ghost[w->bodies.slot[i]] = DEMI_GHOST_ABOVE;
        b->lent[n++] = (int32_t)w->bodies.slot[i];
    }
    if (!demi_pack(w, w, w->bodies.ghost, DEMI_GHOST_ABOVE, 0, s->axis,
                   demi_slab_shift(s, b, 1),
                   &b->out[1])) b->result = demi_no_memory(w, "dem_slabs_step");
    for (i = 0; i < n; i++) w->bodies.ghost[b->lent[i]] = 0;
    b->lent_count = n;
}
/* Reals sent up and down per ghost and step. */
static size_t demi_slab_up(const dem_world *w) {
    return w->bodies.orienting ? 19 : demi_spins(w) ? 15 : 6;
}
static size_t demi_slab_down(const dem_world *w) { return demi_turns(w) ? 6 : 3; }

/* Bytes of what goes up and down in a step. */
static void demi_slab_sizes(dem_slabs *s, demi_slab *b) {
    const size_t up = demi_slab_up(b->world)*sizeof(dem_real);
    const size_t down = demi_slab_down(b->world)*sizeof(dem_real);
    (void)s;
    b->in[0].size = (size_t)b->ghost_count*up;
    b->in[1].size = (size_t)b->lent_count*down;
    b->out[0].size = (size_t)b->ghost_count*down;
}
/* Ghosts come in; then the list is made as in any world, and steps get their room. */
static void demi_slab_list(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    const char *from = 0;
    const demi_message_head h = demi_slab_head(s, b, 0, &from);
    int i, d, ok;
    ok = demi_bodies_reserve(w, (size_t)w->bodies.count + (size_t)h.grains) &&
         DEMI_GROW(w, b->ghost, (size_t)h.grains) &&
         DEMI_GROW(w, b->ghost_inv, 2*(size_t)h.grains);
    if (!ok) { b->result = demi_no_memory(w, "dem_slabs_step"); return; }
    for (i = 0; i < h.grains; i++) {
        const int at = demi_grain_append(w, &from);
        w->bodies.ghost[w->bodies.slot[at]] = DEMI_GHOST;
        b->ghost[i] = (int32_t)w->bodies.slot[at];
        b->ghost_inv[2*i] = w->bodies.inv_mass[at];
        b->ghost_inv[2*i + 1] = w->bodies.inv_inertia[at];
    }
    b->ghost_count = h.grains;
    if (s->count > 1) w->desc.skin = s->head.margin.skin > 0 ? (dem_real)s->head.margin.skin : -1;
    b->result = demi_rebuild(w, "dem_world_step");
    if (b->result != DEM_OK) return;
    demi_kernel_choose(w);
    for (i = 0; i < b->ghost_count; i++) b->ghost[i] = w->bodies.slot_index[b->ghost[i]];
    for (i = 0; i < b->lent_count; i++) b->lent[i] = w->bodies.slot_index[b->lent[i]];
    demi_slab_sizes(s, b);
    b->work = 4.0*w->bodies.count;
    for (d = 0; d < w->domain_count; d++)
        b->work += w->domains[d].own + w->domains[d].cross + w->domains[d].walls;
}
/* The outboxes rest until everybody has taken from them; only then are they given their room. */
static void demi_slab_settle(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    (void)s;
    b->out[1].size = (size_t)b->lent_count*demi_slab_up(w)*sizeof(dem_real);
    if (!DEMI_GROW(w, b->in[0].bytes, b->in[0].size) ||
        !DEMI_GROW(w, b->in[1].bytes, b->in[1].size) ||
        !DEMI_GROW(w, b->out[0].bytes, b->out[0].size) ||
        !DEMI_GROW(w, b->out[1].bytes, b->out[1].size))
        b->result = demi_no_memory(w, "dem_slabs_step");
}

/* Migration: round by round, since a grain moves on by one slab at a time. */
static dem_result demi_slabs_migrate(dem_slabs *s) {
    dem_result result;
    for (;;) {
        double leavers = 0;
        int k;
        demi_slabs_phase(s, demi_slab_leave);
        for (k = 0; k < s->local; k++) leavers = DEMI_MAX(leavers, s->slabs[k].leavers);
        result = demi_slabs_agree(s, &leavers, 1);
        if (result != DEM_OK || !(leavers > 0)) return result;
        result = demi_slabs_exchange(s, DEMI_UP | DEMI_DOWN, 0);
        if (result != DEM_OK) return result;
        demi_slabs_phase(s, demi_slab_room);
        result = demi_slabs_agree(s, 0, 0);
        if (result != DEM_OK) return result;
        demi_slabs_phase(s, demi_slab_migrate);
    }
}
/* DEM_ERROR_MEMORY leaves every grain in one slab and its memory beside it: the next call begins
   again. */
static dem_result demi_slabs_rebuild(dem_slabs *s) {
    dem_world *h = &s->head;
    const double skin_before = h->margin.skin_auto;
    dem_result result;
    h->stage.list_valid = 0;
    demi_slabs_phase(s, demi_slab_drop);
    result = demi_slabs_agree(s, 0, 0);
    if (s->count > 1) {
        if (result == DEM_OK) result = demi_slabs_skin(s);
        if (result == DEM_OK) result = demi_slabs_balance(s);
        if (result == DEM_OK) { demi_slabs_space(s); result = demi_slabs_migrate(s); }
        if (result == DEM_OK) {
            demi_slabs_phase(s, demi_slab_invite);
            result = demi_slabs_agree(s, 0, 0);
        }
        if (result == DEM_OK) result = demi_slabs_exchange(s, DEMI_UP, 0);
    }
    if (result == DEM_OK) {
        demi_slabs_phase(s, demi_slab_list);
        result = demi_slabs_agree(s, 0, 0);
    }
    if (result == DEM_OK) {
        demi_slabs_phase(s, demi_slab_settle);
        result = demi_slabs_agree(s, 0, 0);
    }
    if (result != DEM_OK) { h->margin.skin_auto = skin_before; return result; }
    if (s->count == 1) h->margin.skin = s->slabs[0].world->margin.skin;
    h->margin.gone = h->margin.walls_gone = 0;
    h->clock.last_rebuild = h->clock.steps;
    h->clock.rebuilds++;
    h->stage.list_valid = 1;
    return DEM_OK;
}

/* --- a step --- */

/* 1 move. Ghosts stand still, weightless: their owner moves them. */
static void demi_slab_move(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    int k;
    if (b->result != DEM_OK) return;            /* from the forces before: told with this step */
    for (k = 0; k < b->ghost_count && !s->head.stage.moved; k++) {
        const int i = b->ghost[k];
        w->bodies.inv_mass[i] = w->bodies.inv_inertia[i] = 0;
        demi_put(w->bodies.vel + 4*i, demi_v(0, 0, 0));      demi_put(w->bodies.half_vel + 4*i,
                                                                      demi_v(0, 0, 0));
        demi_put(w->bodies.spin + 4*i, demi_v(0, 0, 0));     demi_put(w->bodies.half_spin + 4*i,
                                                                      demi_v(0, 0, 0));
        demi_put(w->bodies.force + 4*i, demi_v(0, 0, 0));    demi_put(w->bodies.torque + 4*i,
                                                                      demi_v(0, 0, 0));
        if (w->bodies.backward) demi_put(w->bodies.last_pos + 4*i, demi_at(w->bodies.pos + 4*i));
    }
    if (!s->head.stage.moved) b->result = demi_step_move(w);
    if (b->result == DEM_OK) b->result = demi_outflow(w);
}
/* Outlets take what this slab owns; whoever lost one needs a new list. */
static void demi_slab_outlets(dem_slabs *s, demi_slab *b) {
    (void)s;
    b->result = demi_outlets_run(b->world);
}
/* Outlets of all slabs; *search: somebody lost a grain. */
static dem_result demi_slabs_outlets(dem_slabs *s, int *search) {
    dem_result result;
    double stale = 0;
    int k;
    demi_slabs_phase(s, demi_slab_outlets);
    for (k = 0; k < s->local; k++)
        stale = DEMI_MAX(stale, !s->slabs[k].world->stage.list_valid);
    result = demi_slabs_agree(s, &stale, 1);
    *search |= stale > 0;
    return result;
}
/* What the walls did, for those slabs whose walls do not move by themselves. */
static void demi_slabs_poses(dem_slabs *s) {
    const dem_world *from = s->slabs[0].world;
    int k, i;
    for (i = 0; i < from->wall_count; i++)
        for (k = 1; k < s->local && from->walls[i].motion.kind != DEM_MOTION_FIXED; k++) {
            s->slabs[k].world->walls[i].pose = from->walls[i].pose;
            s->slabs[k].world->walls[i].mid = from->walls[i].mid;
        }
}
/* State of the grains that are ghosts above: as much of it as the laws in force look at. */
static void demi_slab_send(dem_slabs *s, demi_slab *b) {
    const dem_world *w = b->world;
    const size_t three = 3*sizeof(dem_real), reals = demi_slab_up(w);
    const dem_real shift = demi_slab_shift(s, b, 1);
    dem_real *out = (dem_real *)b->out[1].bytes;
    int k;
    for (k = 0; k < b->lent_count; k++, out += reals) {
        const int i = 4*b->lent[k];
        memcpy(out, w->bodies.pos + i, three);
        out[s->axis] += shift;
        memcpy(out + 3, w->bodies.vel + i, three);
        if (reals == 6) continue;
        memcpy(out + 6, w->bodies.spin + i, three);
        memcpy(out + 9, w->bodies.half_vel + i, three);
        memcpy(out + 12, w->bodies.half_spin + i, three);
        if (reals == 19) memcpy(out + 15, w->bodies.orient + i, 4*sizeof(dem_real));
    }
}
/* Ghosts are where their owners say. */
static void demi_slab_receive(const dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    const size_t three = 3*sizeof(dem_real), up = demi_slab_up(w);
    const dem_real *in = b->ghost_count ? (const dem_real *)demi_slab_inbox(s, b, 0)->bytes
        : 0;
    int k;
    for (k = 0; k < b->ghost_count; k++, in += up) {
        const int i = b->ghost[k];
        memcpy(w->bodies.pos + 4*i, in, three);
        memcpy(w->bodies.vel + 4*i, in + 3, three);
        w->bodies.inv_mass[i] = b->ghost_inv[2*k];
        w->bodies.inv_inertia[i] = b->ghost_inv[2*k + 1];
        if (up == 6) continue;
        memcpy(w->bodies.spin + 4*i, in + 6, three);
        memcpy(w->bodies.half_vel + 4*i, in + 9, three);
        memcpy(w->bodies.half_spin + 4*i, in + 12, three);
        if (up == 15) continue;
        memcpy(w->bodies.orient + 4*i, in + 15, 4*sizeof(dem_real));
        if (w->bodies.centres_valid && demi_shape_of(w, i) && demi_shape_of(w, i)->count)
            demi_centres_rotate(w, i);
    }
}
/* The near list, where it is due. */
static void demi_slab_near(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    demi_slab_receive(s, b);
    if (!demi_near_due(w)) return;
    demi_near_choose(w);
    if (!demi_near_make(w, 0)) b->result = demi_no_memory(w, "dem_slabs_step");
}
/* 3 touch. Where bodies are not spheres it may run out of room; all agree before any force is
   worked out, since memory follows a step once. Else there is room, see demi_kept_room. */
static void demi_slab_touch(dem_slabs *s, demi_slab *b) {
    demi_slab_receive(s, b);
    if (!demi_touch(b->world)) b->result = demi_no_memory(b->world, "dem_slabs_step");
}
/* 4 respond, 5 gather, here; forces on ghosts go into the lower outbox. */
static void demi_slab_forces(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    const size_t three = 3*sizeof(dem_real), down = demi_slab_down(w);
    dem_real *out = (dem_real *)b->out[0].bytes;
    double deepest = 0;
    int k, d, finite = 1;
    if (!w->bodies.orienting) demi_slab_touch(s, b);
    demi_forces(w);
    for (k = 0; k < b->ghost_count; k++, out += down) {
        memcpy(out, w->bodies.force + 4*b->ghost[k], three);
        if (down == 6) memcpy(out + 3, w->bodies.torque + 4*b->ghost[k], three);
    }
    if (!w->stage.forces_valid) return;               /* only looking */
    for (d = 0; d < w->domain_count; d++) {
        deepest = DEMI_MAX(deepest, w->domains[d].overlap);
        if (demi_own(w)) finite &= w->domains[d].check < 1e300;
    }
    if (!finite || !(deepest < 1)) b->result = demi_unstable(w);
}
/* Forces on own grains that are ghosts above come back, in the order in which they were lent. */
static void demi_slab_add(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    const size_t down = demi_slab_down(w);
    const dem_real *in = b->lent_count ? (const dem_real *)demi_slab_inbox(s, b, 1)->bytes
        : 0;
    int k, e;
    for (k = 0; k < b->lent_count; k++, in += down)
        for (e = 0; e < 3; e++) {
            w->bodies.force[4*b->lent[k] + e] += in[e];
            if (down == 6) w->bodies.torque[4*b->lent[k] + e] += in[3 + e];
        }
}
/* near: some slab's near list may have to be made anew first. */
static dem_result demi_slabs_forces(dem_slabs *s, int near) {
    dem_result result = DEM_OK;
    if (s->count > 1) {
        demi_slabs_phase(s, demi_slab_send);
        result = demi_slabs_exchange(s, DEMI_UP, 1);
        if (result != DEM_OK) return result;
    }
    if (near) {
        demi_slabs_phase(s, demi_slab_near);
        result = demi_slabs_agree(s, 0, 0);
        if (result != DEM_OK) return result;
    }
    if (s->slabs[0].world->bodies.orienting) {
        demi_slabs_phase(s, demi_slab_touch);
        result = demi_slabs_agree(s, 0, 0);
        if (result != DEM_OK) return result;
    }
    demi_slabs_phase(s, demi_slab_forces);
    if (s->count == 1) return DEM_OK;
    result = demi_slabs_exchange(s, DEMI_DOWN, 1);
    if (result == DEM_OK) demi_slabs_phase(s, demi_slab_add);
    return result;
}

static void demi_slab_finish(dem_slabs *s, demi_slab *b) { (void)s; demi_finish(b->world); }
static void demi_slab_prime(dem_slabs *s, demi_slab *b) {
    (void)s;
    demi_finish(b->world);
    demi_prime(b->world);
}
static void demi_slab_refresh(dem_slabs *s, demi_slab *b) {
    (void)s;
    demi_kernel_choose(b->world);
    b->world->stage.forces_valid = 0;
}
static void demi_slab_sample(dem_slabs *s, demi_slab *b) {
    (void)s;
    demi_finish(b->world);
    demi_fields_sample(b->world);
}

/* As demi_refresh: forces at the present time, by a new list where somebody has none. */
static dem_result demi_slabs_refresh(dem_slabs *s) {
    dem_result result;
    double stale = !s->head.stage.list_valid;
    int k;
    demi_slabs_phase(s, demi_slab_finish);
    for (k = 0; k < s->local; k++) stale = DEMI_MAX(stale, !s->slabs[k].world->stage.list_valid);
    result = demi_slabs_agree(s, &stale, 1);
    if (result == DEM_OK && stale > 0) result = demi_slabs_rebuild(s);
    if (result != DEM_OK) return result;
    demi_slabs_phase(s, demi_slab_refresh);
    result = demi_slabs_forces(s, 0);
    if (result != DEM_OK) return result;
    for (k = 0; k < s->local; k++) s->slabs[k].world->stage.forces_valid = 1;
    s->head.stage.forces_valid = 1;
    return DEM_OK;
}

/* One step, in the order of demi_step_once. */
static dem_result demi_slabs_step_once(dem_slabs *s) {
    dem_world *h = &s->head;
    const dem_world *first = s->slabs[0].world;
    /* speed, list stale, walls' reach, last change; near lists' creep, age over what they allow;
       reach */
    double flags[7] = {0, 0, 0, 0, -1e300, -1e300, 0};
    const double dt = (double)h->clock.dt;
    dem_result result;
    int k, near, search;
    demi_slabs_phase(s, demi_slab_move);
    for (k = 0; k < s->local; k++) {
        const dem_world *w = s->slabs[k].world;
        flags[0] = DEMI_MAX(flags[0], w->booked.speed_max);
        flags[1] = DEMI_MAX(flags[1], !w->stage.list_valid);
        flags[3] = DEMI_MAX(flags[3], w->margin.last_change);
        flags[4] = DEMI_MAX(flags[4],
                            w->margin.creep + 2*w->margin.change*dt - w->margin.slack);
        flags[5] = DEMI_MAX(flags[5], w->margin.age + dt - w->margin.span*(1 - 1e-9));
        flags[6] = DEMI_MAX(flags[6], w->margin.step_gone);
    }
    flags[2] = first->margin.walls_gone;
    if (!h->stage.moved) {
        h->stage.moved = 1;
        h->clock.time = first->clock.time;
        h->clock.since = first->clock.since;
        h->clock.steps++;
        demi_slabs_poses(s);
        result = demi_slabs_agree(s, flags, 7);
        h->booked.speed_max = flags[0];
        h->margin.gone += flags[6];
        for (k = 0; k < s->local; k++) demi_near_pass(s->slabs[k].world, flags[3]);
        h->near_due = flags[4] + 2*flags[3]*dt > -1e-6*h->margin.skin || flags[5] > -1e-6*dt;
    } else result = demi_slabs_agree(s, flags, 7);
    if (result != DEM_OK) return result;
    near = s->count == 1 || h->near_due;        /* each looks for itself again */
    if (s->count == 1) h->margin.gone = first->margin.gone;
    h->margin.walls_gone = flags[2];
    for (k = 0; k < s->local && s->count > 1; k++) {           /* what lists count on */
        s->slabs[k].world->margin.gone = h->margin.gone;
        s->slabs[k].world->margin.walls_gone = h->margin.walls_gone;
    }
    search = flags[1] > 0 || !h->stage.list_valid || h->margin.skin <= 0 ||
             2*h->margin.gone > h->margin.skin ||
             h->margin.gone + h->margin.walls_gone > h->margin.skin;
    if (first->outlet_count && (search || h->clock.steps%DEMI_OUTLET_REST == 0)) {
        result = demi_slabs_outlets(s, &search);
        if (result != DEM_OK) return result;
    }
    if (search) {
        result = demi_slabs_rebuild(s);
        if (result != DEM_OK) return result;
        if (h->booked.speed_max > 1.5*h->clock.assumed_speed) h->stage.dt_valid = 0;
        near = 0;
    }
    result = demi_slabs_forces(s, near);
    if (result == DEM_OK) h->stage.moved = 0;
    return result;
}

/* ---------------------------------------------------------------------------------------------
   >>slabs-time
   One time step for all slabs, as >>advice finds it for one world: chosen, or refused, by what all
   of them hold together, before anything moves.
   --------------------------------------------------------------------------------------------- */

/* The head stands in for the whole scene when a time step is chosen: of each material the smallest
   grains that move and the largest that does not; all at the highest speed, and two of them at the
   ends of the fall there is. */
static dem_result demi_slabs_stand_in(dem_slabs *s) {
    dem_world *h = &s->head;
    const dem_real g = demi_length(h->desc.gravity);
    const dem_vec3 down = g > 0 ? demi_unit(h->desc.gravity) : demi_v(0, 0, 0);
    const int m = h->material_count;
    double *v = s->values, many[DEMI_MATERIALS];
    dem_result result;
    int k, i, j;
    for (i = 0; i < 2*m; i++) v[i] = i < m ? -1e300 : 0;       /* minus smallest; largest fixed */
    v[2*m] = v[2*m + 3] = v[2*m + 4] = 0;       /* speed; lowest, highest; spin; of what moves */
    v[2*m + 1] = v[2*m + 2] = -1e300;
    memset(many, 0, sizeof many);
    for (k = 0; k < s->local; k++) {
        const dem_world *w = s->slabs[k].world;
        for (i = 0; i < w->bodies.count; i++) {
            const double x = (double)demi_dot(demi_at(w->bodies.pos + 4*i), down);
            const double r = (double)w->bodies.pos[4*i + 3];
            double speed;
            if (demi_is_ghost(w, i)) continue;
            j = w->bodies.material[i] - 1;
            speed = (double)demi_length(demi_at(w->bodies.vel + 4*i));
            if (w->bodies.inv_mass[i] > 0) {
                v[j] = DEMI_MAX(v[j], -demi_advise_radius(w, i));
                v[2*m + 4] = DEMI_MAX(v[2*m + 4], speed);
                many[j]++;
            } else v[m + j] = DEMI_MAX(v[m + j], demi_advise_radius(w, i));
            v[2*m] = DEMI_MAX(v[2*m], speed);
            v[2*m + 1] = DEMI_MAX(v[2*m + 1], r - x);
            v[2*m + 2] = DEMI_MAX(v[2*m + 2], r + x);
            if (demi_shape_of(w, i))
                v[2*m + 3] = DEMI_MAX(v[2*m + 3],
                                      (double)demi_length(demi_at(w->bodies.spin + 4*i)));
        }
    }
    result = demi_slabs_reduce(s, v, 2*m + 5, 0);
    h->clock.spin_elsewhere = v[2*m + 3];
    h->booked.speed_max = v[2*m + 4];
    if (result == DEM_OK) result = demi_slabs_reduce(s, many, m, 1);
    h->bodies.count = 0;
    for (j = 0; j < m && result == DEM_OK; j++)
        for (k = 0; k < 3; k++) {
            const double r = k < 2 ? -v[j] : v[m + j];
            const double at = h->bodies.count == 0 ? r - v[2*m + 1] : v[2*m + 2] - r;
            if (k < 2 ? many[j] <= k : !(r > 0)) continue;
            i = h->bodies.count++;
            demi_put(h->bodies.pos + 4*i, demi_scale(down, (dem_real)at));
            h->bodies.pos[4*i + 3] = (dem_real)r;
            demi_put(h->bodies.vel + 4*i, demi_v((dem_real)v[2*m], 0, 0));
            h->bodies.inv_mass[i] = k < 2 ? DEM_R(1) : DEM_R(0);
            h->bodies.material[i] = j + 1;
        }
    return result;
}
/* The time step of all: one slab asks itself, more are stood in for by the head. */
static dem_result demi_slabs_settle(dem_slabs *s) {
    dem_world *h = &s->head, *w = s->slabs[0].world;
    const dem_real before = h->clock.dt;
    dem_result result;
    int k;
    if (h->stage.dt_valid) return DEM_OK;
    if (s->count == 1) {
        w->stage.dt_valid = 0;
        result = demi_dt_settle(w);
        memcpy(h->error, w->error, sizeof h->error);
        h->clock.dt = w->clock.dt;
        h->stage.dt_valid = w->stage.dt_valid;
        h->clock.assumed_speed = w->clock.assumed_speed;
        h->stage.primed = w->stage.primed;
        return result;
    }
    demi_slabs_phase(s, demi_slab_finish);
    result = demi_slabs_stand_in(s);
    h->walls = w->walls;
    if (result == DEM_OK) result = demi_dt_settle(h);
    h->walls = 0;
    if (h->clock.dt < before || h->clock.dt > before) h->stage.primed = 0;
    for (k = 0; k < s->local; k++) {
        s->slabs[k].world->clock.dt = h->clock.dt;
        s->slabs[k].world->clock.assumed_speed = h->clock.assumed_speed;
        s->slabs[k].world->stage.dt_valid = 1;
    }
    return result;
}

/* --- as demi_dt_check: a body's contacts are known to its own slab and, across the border, to the
       one above, which sends what it knows of its ghosts down. First the cheap bounds; matrices
       only where those are not enough. --- */

/* Room for `one` bytes of each ghost in the lower outbox, and of what comes from above. */
static int demi_slab_press_room(demi_slab *b, size_t one) {
    dem_world *w = b->world;
    if (!DEMI_GROW(w, b->out[0].bytes, (size_t)b->ghost_count*one) ||
        !DEMI_GROW(w, b->in[1].bytes, (size_t)b->lent_count*one)) return 0;
    b->out[0].size = (size_t)b->ghost_count*one;
    b->in[1].size = (size_t)b->lent_count*one;
    return 1;
}
static void demi_slab_press(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    const size_t n = (size_t)w->bodies.count;
    int k;
    (void)s;
    if (!DEMI_GROW(w, w->press, n) || !demi_slab_press_room(b, sizeof *w->press)) {
        b->result = demi_no_memory(w, "dem_slabs_step");
        return;
    }
    if (n) memset(w->press, 0, n*sizeof *w->press);
    demi_press_visit(w, w->press, 0);
    for (k = 0; k < b->ghost_count; k++)
        memcpy(b->out[0].bytes + (size_t)k*sizeof *w->press, w->press + b->ghost[k],
               sizeof *w->press);
}
/* Adds what comes from above: a bound of the step, from below. */
static void demi_slab_press_take(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    const char *from = b->lent_count ? demi_slab_inbox(s, b, 1)->bytes : 0;
    demi_press told;
    int i, k;
    for (k = 0; k < b->lent_count; k++) {
        demi_press *sum = w->press + b->lent[k];
        demi_unpack(&from, &told, sizeof told);
        sum->omega2 += told.omega2;
        sum->rate += told.rate;
        sum->contacts += told.contacts;
        sum->deepest = DEMI_MAX(sum->deepest, told.deepest);
    }
    b->press_limit = 1e300;
    for (i = 0; i < w->bodies.count; i++)
        if (!demi_is_ghost(w, i))
            b->press_limit = DEMI_MIN(b->press_limit, demi_dt_stable(w->press[i].omega2,
                                                                     w->press[i].rate));
}
static void demi_slab_press_whole(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    const size_t n = (size_t)w->bodies.count, one = sizeof *w->press_whole;
    int i, k;
    (void)s;
    if (!DEMI_GROW(w, w->press_whole, n) || !demi_slab_press_room(b, one)) {
        b->result = demi_no_memory(w, "dem_slabs_step");
        return;
    }
    if (n) memset(w->press_whole, 0, n*one);
    for (i = 0; i < w->bodies.count; i++) w->press[i].whole = i + 1;
    demi_press_visit(w, w->press, w->press_whole);
    for (k = 0; k < b->ghost_count; k++)
        memcpy(b->out[0].bytes + (size_t)k*one, w->press_whole + b->ghost[k], one);
}
static void demi_slab_press_limit(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    const char *from = b->lent_count ? demi_slab_inbox(s, b, 1)->bytes : 0;
    demi_press_whole told;
    int i, k;
    for (k = 0; k < b->lent_count; k++) {
        double *to = (double *)(void *)(w->press_whole + b->lent[k]);
        const double *add = (const double *)(const void *)&told;
        demi_unpack(&from, &told, sizeof told);
        for (i = 0; i < (int)(sizeof told/sizeof *to); i++) to[i] += add[i];
    }
    b->press_limit = 1e300;
    for (i = 0; i < w->bodies.count; i++) {
        const demi_press_whole *p = w->press_whole + i;
        const double limit = demi_is_ghost(w, i) ? 1e300
            : demi_dt_stable(demi_press_bound(p, 0), demi_press_bound(p, 1));
        if (limit < b->press_limit) { b->press_limit = limit; b->press_worst = i; }
    }
}
/* Lets all slabs say what they know of ghosts and take what is told of their own, then agree on the
   smallest limit. Outboxes are then as long again as steps need them. */
static dem_result demi_slabs_press_ask(dem_slabs *s, void (*say)(dem_slabs *, demi_slab *),
                                       void (*take)(dem_slabs *, demi_slab *), double *limit) {
    double most = -1e300;                       /* less the limit: maxima are what is agreed on */
    dem_result result;
    int k;
    demi_slabs_phase(s, say);
    result = demi_slabs_agree(s, 0, 0);
    if (result == DEM_OK) result = demi_slabs_exchange(s, DEMI_DOWN, 1);
    if (result == DEM_OK) demi_slabs_phase(s, take);
    demi_slabs_phase(s, demi_slab_sizes);
    if (result != DEM_OK) return result;
    for (k = 0; k < s->local; k++) most = DEMI_MAX(most, -s->slabs[k].press_limit);
    result = demi_slabs_agree(s, &most, 1);
    *limit = -most;
    return result;
}
static dem_result demi_slabs_press(dem_slabs *s) {
    dem_world *h = &s->head;
    const int chosen = !(h->desc.dt > 0);
    const double dt = (double)h->clock.dt*(chosen ? 2 : 1);
    double limit = 0;
    dem_result result;
    int k;
    result = demi_slabs_press_ask(s, demi_slab_press, demi_slab_press_take, &limit);
    if (result == DEM_OK && limit < dt)
        result = demi_slabs_press_ask(s, demi_slab_press_whole, demi_slab_press_limit, &limit);
    if (result != DEM_OK) return result;
    demi_press_looked(&h->clock);
    if (limit >= dt) return DEM_OK;
    for (k = 0; k < s->local; k++) {
        demi_slab *b = &s->slabs[k];
        if (chosen) b->world->clock.dt = (dem_real)(limit/2);
        else if (!(b->press_limit > limit))
            b->result = demi_press_refuse(b->world, limit, b->press_worst);
    }
    if (!chosen) return demi_slabs_agree(s, 0, 0);
    demi_slabs_phase(s, demi_slab_finish);
    h->clock.dt = (dem_real)(limit/2);
    h->stage.primed = 0;
    return DEM_OK;
}
static dem_result demi_slabs_dt_check(dem_slabs *s) {
    dem_world *h = &s->head, *w = s->slabs[0].world;
    dem_result result;
    if (h->desc.allow_large_dt) return DEM_OK;
    if (s->count == 1) {
        result = demi_dt_check(w);
        memcpy(h->error, w->error, sizeof h->error);
        h->clock.dt = w->clock.dt;
        h->stage.primed = h->stage.primed && w->stage.primed;
        return result;
    }
    result = demi_speed_check(h, h->booked.speed_max + w->margin.last_change, 0);
    if (result == DEM_OK) {
        result = demi_wall_speed_check(w, (double)h->effects.radius_min, (double)h->clock.dt);
        if (result != DEM_OK) memcpy(h->error, w->error, sizeof h->error);
    }
    return result != DEM_OK || h->clock.steps < h->clock.press_due ? result : demi_slabs_press(s);
}

/* ---------------------------------------------------------------------------------------------
   >>slabs-run
   Feeds into slabs, and one step after the other. The head has the feeds and draws, in every
   process the same; each slab says who is near; the one whose part of the scene a new grain is in
   takes it. Its slot is one nobody has had, and all lists are made anew before the step; forces
   stay as they are, for it touches nobody.
   --------------------------------------------------------------------------------------------- */

/* Slot numbers are those of the whole scene: every slab gets room for one more. 0: no memory. */
static int demi_slab_widen(demi_slab *b, int slot) {
    dem_world *w = b->world;
    return demi_bodies_reserve(w, (size_t)w->bodies.count + 1) &&
           DEMI_GROW(w, w->bodies.ghost, (size_t)slot + 2);
}
/* Who is near a feed's region, each slab for itself; distances are those of the whole scene, which
   may be periodic where a slab is not. */
static dem_result demi_slabs_look(void *who, const demi_region *g, dem_real radius) {
    dem_slabs *s = (dem_slabs *)who;
    int k;
    if (!s->head.stage.primed) demi_slabs_phase(s, demi_slab_finish);
    for (k = 0; k < s->local; k++) {
        demi_slab *b = &s->slabs[k];
        if (!demi_crowd_begin(b->world, &b->crowd, g, radius, demi_periods_of(&s->head)))
            b->result = demi_no_memory(b->world, "dem_slabs_step");
    }
    return demi_slabs_agree(s, 0, 0);
}
/* Room for a grain at x of radius r, and for its slot; `owner`: the slab that takes it, if it is in
   this process. */
static dem_result demi_slabs_feed_room(dem_slabs *s, demi_slab *owner, dem_vec3 x, dem_real r) {
    int k;
    for (k = 0; k < s->local; k++)
        if (!demi_slab_widen(&s->slabs[k], s->slots))
            s->slabs[k].result = demi_no_memory(s->slabs[k].world, "dem_slabs_step");
    if (!DEMI_GROW(&s->head, s->known, (size_t)s->slots + 2))
        s->slabs[0].result = demi_no_memory(s->slabs[0].world, "dem_slabs_step");
    if (owner && owner->result == DEM_OK &&
        (!demi_crowd_put(owner->world, &owner->crowd, x, r, owner->world->bodies.count) ||
         !demi_list_drop(owner->world)))
        owner->result = demi_no_memory(owner->world, "dem_slabs_step");
    return demi_slabs_agree(s, 0, 0);
}
/* All places that may be tried are asked about at once: is anybody in the way? Then the first that
   is free counts, as in a world that tries one after the other. */
static int demi_slabs_put(void *who, demi_feed *f, const demi_region *g) {
    dem_slabs *s = (dem_slabs *)who;
    dem_world *h = &s->head;
    const dem_real r = f->desc.radius[f->next];
    const demi_periods p = demi_periods_of(h);
    const uint64_t random = f->random;
    uint64_t after[DEMI_FEED_TRIES];
    double taken[DEMI_FEED_TRIES], at[3];
    dem_vec3 x[DEMI_FEED_TRIES], v[DEMI_FEED_TRIES];
    demi_slab *owner = 0;
    dem_result result;
    int n, k;
    for (n = 0; n < DEMI_FEED_TRIES; n++) {
        taken[n] = !demi_feed_try(h, f, g, &x[n], &v[n]) ||
                   !demi_walls_clear(s->slabs[0].world, x[n], r);
        after[n] = f->random;
        for (k = 0; k < s->local && !(taken[n] > 0); k++)
            taken[n] = !demi_crowd_free(s->slabs[k].world, &s->slabs[k].crowd, x[n], r);
    }
    result = demi_slabs_reduce(s, taken, DEMI_FEED_TRIES, 0);
    for (n = 0; n < DEMI_FEED_TRIES && taken[n] > 0; n++) continue;
    if (result == DEM_OK && n == DEMI_FEED_TRIES) return 0;
    if (result == DEM_OK) {
        x[n] = demi_place_of(&p, x[n]);
        at[0] = (double)x[n].x; at[1] = (double)x[n].y; at[2] = (double)x[n].z;
        for (k = 0; k < s->local; k++)
            if ((s->slabs[k].index == 0 || at[s->axis] >= s->borders[s->slabs[k].index]) &&
                (s->slabs[k].index == s->count - 1 ||
                 at[s->axis] < s->borders[s->slabs[k].index + 1])) owner = &s->slabs[k];
        result = demi_slabs_feed_room(s, owner, x[n], r);
    }
    if (result != DEM_OK) { f->random = random; return -(int)result; }
    f->random = after[n];
    for (k = 0; k < s->local; k++) {
        demi_bodies *bodies = &s->slabs[k].world->bodies;
        const int rest = bodies->slot_free;
        bodies->slot_free = -1;                 /* a number nobody has had: the next */
        bodies->slot_index[s->slots] = -1;
        bodies->slot_generation[s->slots] = 1;
        bodies->ghost[s->slots] = 0;
        bodies->slot_count = s->slots + (&s->slabs[k] != owner);
        if (&s->slabs[k] == owner) {
            const int i = demi_feed_append(owner->world, f, x[n], v[n]);
            if (h->stage.primed) demi_prime_body(owner->world, i);
        }
        bodies->slot_free = rest;
    }
    s->known[s->slots++] = 1;
    h->bodies.balance.inserted++;
    h->booked.speed_max = DEMI_MAX(h->booked.speed_max, (double)demi_length(v[n]));
    h->stage.list_valid = 0;
    if (h->desc.force || h->desc.body_force) demi_scene_changed(h);
    demi_feed_count(f);
    return 1;
}
/* All that is due; then the time step may be another. */
static dem_result demi_slabs_feed(dem_slabs *s) {
    demi_feeder feeder;
    dem_result result;
    if (!s->head.feed_count) return DEM_OK;
    feeder.look = demi_slabs_look;
    feeder.put = demi_slabs_put;
    feeder.who = s;
    result = demi_feeds_run(&s->head, &feeder);
    return result == DEM_OK ? demi_slabs_settle(s) : result;
}

/* Not after the transport has failed. */
static dem_result demi_slabs_usable(dem_slabs *s, const char *call) {
    if (!s->broken) return DEM_OK;
    return demi_fail(&s->head, DEM_ERROR_STOPPED, "%s: the transport failed before, so slabs may "
                     "have lost step; create them anew from the last collected world or checkpoint",
                     call);
}
DEM_API dem_result dem_slabs_step(dem_slabs *s, int steps) {
    if (!s) return DEM_ERROR_ARGUMENT;
    dem_result result = demi_slabs_usable(s, "dem_slabs_step");
    dem_world *h = &s->head;
    int i, f, whole = 1;
    if (result != DEM_OK) return result;
    if (steps < 0)
        return demi_fail(h, DEM_ERROR_ARGUMENT, "dem_slabs_step: steps is %d, must be >= 0",
                         steps);
    for (i = 0; i < steps && result == DEM_OK; i++) {
        const dem_world *w = s->slabs[0].world;
        int sampling = 0;
        if (!h->stage.moved) {
            result = demi_slabs_settle(s);
            if (result == DEM_OK) result = demi_slabs_feed(s);
            if (result == DEM_OK && !h->stage.forces_valid) result = demi_slabs_refresh(s);
            else if (result == DEM_OK && !h->stage.list_valid) result = demi_slabs_rebuild(s);
            if (result == DEM_OK) result = demi_slabs_dt_check(s);
            if (result != DEM_OK) break;
            if (!h->stage.primed) { demi_slabs_phase(s, demi_slab_prime); h->stage.primed = 1; }
        }
        result = demi_slabs_step_once(s);
        whole = result == DEM_OK;
        for (f = 0; f < w->field_count; f++)
            sampling |= w->fields[f].used && w->clock.time >= w->fields[f].next;
        if (sampling && whole) demi_slabs_phase(s, demi_slab_sample);
    }
    if (!whole) return result;
    if (result == DEM_OK) result = demi_slabs_agree(s, 0, 0);  /* of the last forces */
    if (!h->stage.moved) demi_slabs_phase(s, demi_slab_finish);
    return result;
}

/* ---------------------------------------------------------------------------------------------
   >>deal
   Dealing a scene to slabs and collecting it again: their worlds, what each process finds out
   about the others' when they are made, and the state of all of them written into one world. A
   slab's world has the scene's materials, shapes, walls, fields and outlets, and slots for all
   bodies there are; geometry is held once in a process. Collecting first asks whether the world
   can take everything, then gets all its room, then writes: refused, it has changed nothing.
   --------------------------------------------------------------------------------------------- */

/* --- an allocator of the user's own, as slabs on several threads see it --- */
static void *demi_slabs_alloc(size_t size, void *user) {
    const dem_allocator *a = (const dem_allocator *)user;
    void *p;
#if DEMI_OPENMP
    #pragma omp critical(demi_slabs)            /* the user's may be called by one at a time */
#endif
    p = a->alloc_fn(size, a->user);
    return p;
}
static void demi_slabs_free(void *memory, size_t size, void *user) {
    const dem_allocator *a = (const dem_allocator *)user;
#if DEMI_OPENMP
    #pragma omp critical(demi_slabs)
#endif
    a->free_fn(memory, size, a->user);
}

/* Copies the walls; slabs after the first share the geometry of the first. */
static int demi_slab_walls(dem_world *to, const dem_world *from, const dem_world *first) {
    const size_t n = (size_t)from->wall_count;
    int i;
    to->walls = (demi_wall *)demi_hold(to, DEMI_RUN, n, sizeof *to->walls);
    if (!n) return 1;
    if (!to->walls) return 0;
    for (i = 0; i < from->wall_count; i++) {
        demi_wall *b = &to->walls[i];
        *b = first ? first->walls[i] : from->walls[i];
        if (!first && !demi_wall_own(to, b)) return 0;
        if (first) b->motion.kind = DEM_MOTION_FIXED;
        to->wall_count = i + 1;
    }
    to->facets_valid = first || from->facets_valid;
    return to->facets_valid || demi_facets_weigh(to);
}
/* Copies the shapes; slabs after the first share those of the first. 0 when memory ran out. */
static int demi_slab_shapes(dem_world *to, const dem_world *from, const dem_world *first) {
    int i;
    if (first) {
        to->shapes = first->shapes;
        to->shape_count = first->shape_count;
        return 1;
    }
    for (i = 0; i < from->shape_count; i++) {
        demi_shape shape = from->shapes[i];
        const size_t reals = 4*(size_t)shape.count;
        if (reals) {
            shape.parts = (dem_real *)demi_hold(to, DEMI_SCENE, reals, sizeof(dem_real));
            if (!shape.parts) return 0;
            memcpy(shape.parts, from->shapes[i].parts, reals*sizeof(dem_real));
        }
        if (!demi_shape_adopt(to, "dem_slabs_create", &shape).id) return 0;
    }
    return 1;
}
/* What an outlet has let out, of which nothing is known yet. */
static void demi_outlet_clear(demi_outlet *o) {
    const double since = o->state.since, last = o->state.last;
    memset(&o->state, 0, sizeof o->state);
    o->state.since = since;
    o->state.last = last;
}
/* Sums over time begin in slab 0 where the world has got to, elsewhere at nothing. */
static void demi_slab_sums_clear(dem_world *w) {
    int i;
    memset(w->booked.energy, 0, sizeof w->booked.energy);
    w->booked.removed = w->booked.throughput = w->booked.inserted = 0;
    w->bodies.balance.left = 0;
    for (i = 0; i < w->wall_count; i++) {
        const double time = w->walls[i].loads.time;
        memset(&w->walls[i].loads, 0, sizeof w->walls[i].loads);
        w->walls[i].loads.time = time;
    }
    for (i = 0; i < w->outlet_count; i++) demi_outlet_clear(demi_outlet_at(w, i));
}
/* Every slab has all outlets: they stand where they stand, and take what is in that slab. */
static int demi_slab_outlets_copy(dem_world *to, const dem_world *from) {
    if (!DEMI_GROW(to, to->outlets, (size_t)from->outlet_count)) return 0;
    if (from->outlet_count)
        memcpy(to->outlets, from->outlets, (size_t)from->outlet_count*sizeof *to->outlets);
    to->outlet_count = from->outlet_count;
    return 1;
}
/* The head has the feeds; slabs look at them. 0 when memory ran out. */
static int demi_slabs_feeds_copy(dem_world *h, const dem_world *w) {
    if (!DEMI_GROW(h, h->feeds, (size_t)w->feed_count)) return 0;
    if (w->feed_count) memcpy(h->feeds, w->feeds, (size_t)w->feed_count*sizeof *h->feeds);
    h->feed_count = w->feed_count;
    return 1;
}
/* Each slab sums what its own grains add; what there is already, one slab inherits. */
static int demi_slab_fields(dem_world *to, const dem_world *from, int inherit) {
    int i;
    for (i = 0; i < from->field_count; i++) {
        const demi_field *a = &from->fields[i];
        const size_t n = demi_field_cells(a)*sizeof(double);
        if (dem_field_add(to, &a->desc).id != i + 1) return 0;
        to->fields[i].next = a->next;
        to->fields[i].samples = a->samples;
        if (!inherit) continue;
        memcpy(to->fields[i].solid, a->solid, n);
        memcpy(to->fields[i].mass, a->mass, n);
        memcpy(to->fields[i].momentum, a->momentum, 3*n);
    }
    return 1;
}
/* A slab's world: everything of the scene but the grains. */
static dem_world *demi_slab_world(dem_slabs *s, const dem_world *from, int index,
                                  const dem_world *first, dem_allocator *allocator) {
    dem_world_desc desc = from->asked;
    const size_t slots = (size_t)from->bodies.slot_count;
    dem_world *w;
    desc.threads = s->local == 1 ? from->desc.threads : 1;
    if (s->ring) desc.boundary[s->axis] = DEM_BOUNDARY_OPEN;
    if (desc.allocator.alloc_fn) {
        desc.allocator.alloc_fn = demi_slabs_alloc;
        desc.allocator.free_fn = demi_slabs_free;
        desc.allocator.user = allocator;
    }
    w = dem_world_create(&desc);
    if (!w) return 0;
    if (s->ring) w->ring_period[s->axis] = (dem_real)s->period;
    memcpy(w->materials, from->materials, sizeof w->materials);
    memcpy(w->pairs, from->pairs, (size_t)DEMI_MATERIALS*DEMI_MATERIALS*sizeof(demi_pair));
    w->material_count = from->material_count;
    w->feeds = s->head.feeds;
    w->feed_count = s->head.feed_count;
    w->bodies.ghost = (uint8_t *)demi_hold(w, DEMI_RUN, slots + 1, 1);
    w->bodies.slot_index = (int32_t *)demi_hold(w, DEMI_RUN, slots + 1, sizeof(int32_t));
    w->bodies.slot_generation = (uint32_t *)demi_hold(w, DEMI_RUN, slots + 1, sizeof(uint32_t));
    w->bodies.slot_capacity = (int)slots + 1;
    w->bodies.slot_count = (int)slots;
    if (!w->bodies.ghost || !w->bodies.slot_index || !w->bodies.slot_generation ||
        (from->bodies.orienting && !demi_orient_begin(w)) ||
        !demi_slab_shapes(w, from, first) ||
        !demi_slab_walls(w, from, first) || !demi_slab_fields(w, from, index == 0) ||
        !demi_slab_outlets_copy(w, from)) return w;
    memset(w->bodies.slot_index, 0xff, slots*sizeof(int32_t));
    if (slots) memcpy(w->bodies.slot_generation, from->bodies.slot_generation,
                      slots*sizeof(uint32_t));
    w->clock.time = from->clock.time;           w->clock.steps =
        from->clock.steps;       w->clock.rebuilds = from->clock.rebuilds;
    w->clock.since = from->clock.since;
    w->clock.last_rebuild = from->clock.steps;  w->margin.skin_auto = from->margin.skin_auto;
    w->margin.skin = from->margin.skin;           w->clock.dt =
        from->clock.dt;             w->stage.dt_valid = from->stage.dt_valid;
    w->wall_fastest = from->wall_fastest;                         w->margin.span =
        from->margin.span;
    w->margin.slack = from->margin.slack;
    w->clock.assumed_speed = from->clock.assumed_speed;                       w->stage.primed =
        from->stage.primed;
    w->booked.overlap_max =
        from->booked.overlap_max;                           w->booked.speed_max =
            from->booked.speed_max;
    w->bodies.balance = from->bodies.balance;     w->booked.removed = from->booked.removed;
    w->booked.inserted = from->booked.inserted;
    w->booked.throughput =
        from->booked.throughput;                             w->clock.half_kick =
            from->clock.half_kick;
    w->stage.forces_valid = from->stage.forces_valid && !from->stage.pairs_changed;
    memcpy(w->booked.energy, from->booked.energy, sizeof w->booked.energy);
    if (index > 0) demi_slab_sums_clear(w);
    return w;
}
/* Has it got all it was to get? */
static int demi_slab_ready(const dem_world *w, const dem_world *from) {
    return w && w->bodies.ghost && w->bodies.slot_index && w->bodies.slot_generation &&
           w->shape_count == from->shape_count && w->bodies.orienting == from->bodies.orienting &&
           w->wall_count == from->wall_count && w->field_count == from->field_count &&
           w->outlet_count == from->outlet_count;
}
/* The grains of one slab, from the world. */
static int demi_slab_fill(dem_slabs *s, demi_slab *b, const dem_world *from, uint8_t *marks) {
    dem_world *w = b->world;
    const char *at;
    demi_message_head h;
    int i;
    for (i = 0; i < from->bodies.count; i++) {
        const double x = (double)from->bodies.pos[4*i + s->axis];
        marks[from->bodies.slot[i]] = (b->index == 0 || x >= s->borders[b->index]) &&
            (b->index == s->count - 1 || x < s->borders[b->index + 1]);
    }
    b->out[0].size = 0;
    if (!demi_pack(w, from, marks, 1, 1, s->axis, 0, &b->out[0])) return 0;
    at = b->out[0].bytes;
    demi_unpack(&at, &h, sizeof h);
    if (!demi_bodies_reserve(w, (size_t)h.grains) || !demi_filed_reserve(w, &b->add, &h)) return 0;
    for (i = 0; i < h.grains; i++) demi_grain_append(w, &at);
    demi_filed_unpack(w, b->add, &h, at);
    return 1;
}

/* What is wrong with a desc, as a sentence in the world; DEM_OK when nothing is. */
static dem_result demi_slabs_check(dem_world *w, const dem_slabs_desc *d) {
    const char *call = "dem_slabs_create";
    const int local = d->local ? d->local : d->count;
    if (d->axis < 0 || d->axis > 2 || (w->desc.planar && d->axis == 2))
        return demi_fail(w, DEM_ERROR_ARGUMENT, "%s: axis is %d, must be 0, 1 or 2%s; choose the "
                         "one along which the scene is longest", call, d->axis,
                         w->desc.planar ? " (discs live at z = 0: 0 or 1)" : "");
    if (d->count < 1 || d->count > DEMI_SLABS)
        return demi_fail(w, DEM_ERROR_ARGUMENT, "%s: count is %d, must be 1 to %d (required); one "
                         "slab per processor is a good number", call, d->count, (int)DEMI_SLABS);
    if (d->first < 0 || local < 1 || d->first > d->count - local || (!d->local && d->first))
        return demi_fail(w, DEM_ERROR_ARGUMENT, "%s: slabs %d to %d are asked for, must lie in 0 "
                         "to %d; set first and local, or leave both 0 for all", call, d->first,
                         d->first + local - 1, d->count - 1);
    if (!d->transport.exchange_fn != !d->transport.reduce_fn ||
        (local < d->count && !d->transport.exchange_fn))
        return demi_fail(w, DEM_ERROR_ARGUMENT, "%s: %d of %d slabs are here and the transport "
                         "lacks exchange_fn or reduce_fn; give both, or hold all slabs", call,
                         local, d->count);
    if (!demi_finite(d->balance) || (d->balance > 0 && d->balance < 1) || d->balance_interval < 0)
        return demi_fail(w, DEM_ERROR_ARGUMENT, "%s: balance is %g and balance_interval %d, must "
                         "be 0, >= 1 or < 0 (never), and >= 0", call, (double)d->balance,
                         d->balance_interval);
    if (w->stage.moved)
        return demi_fail(w, DEM_ERROR_ARGUMENT, "%s: the world stands in the middle of a step that "
                         "ran out of memory; finish it with dem_world_step first", call);
    return DEM_OK;
}
/* Do all processes hold the same scene in the same order, with a list or without, have they got
   their memory, and all slabs between them? Digests travel as whole numbers of 32 bits. */
static dem_result demi_slabs_same(dem_slabs *s, dem_world *w, int ok) {
    uint64_t digest = demi_scene_digest(w) ^ (dem_world_hash(w) << 1);
    double v[9], slabs = s->local;
    dem_result result;
    int k, differ = 0;
    digest = demi_hash(digest, &w->stage.list_valid, sizeof w->stage.list_valid);
    if (w->bodies.count)
        digest = demi_hash(digest, w->bodies.slot, (size_t)w->bodies.count*sizeof(uint32_t));
    v[0] = (double)(digest >> 32);
    v[2] = (double)(digest & 0xffffffffu);
    v[4] = s->count;
    v[6] = s->axis;
    for (k = 1; k < 8; k += 2) v[k] = -v[k - 1];
    v[8] = !ok;
    result = demi_slabs_reduce(s, v, 9, 0);
    if (result == DEM_OK) result = demi_slabs_reduce(s, &slabs, 1, 1);
    if (result != DEM_OK) return demi_fail(w, result, "%s", s->head.error);
    if (v[8] > 0) return demi_no_memory(w, "dem_slabs_create");
    for (k = 0; k < 8; k += 2) differ |= v[k] + v[k + 1] > 0;
    if (!differ && (int)slabs == s->count) return DEM_OK;
    return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_slabs_create: processes %s, %d slabs of %d are "
                     "asked for; build the same world from the same numbers in every process, "
                     "search or step it in all or none, and ask for every slab once", differ
                     ? "built different scenes" : "do not fit together", (int)slabs, s->count);
}

/* The head's share of a world. 0 when memory ran out. */
static int demi_slabs_head(dem_slabs *s, const dem_world *w) {
    dem_world *h = &s->head;
    const size_t most = 3*DEMI_MATERIALS, n = (size_t)s->count;
    h->asked = w->asked;
    h->stage.synced = 1;
    h->bodies.slot_free = h->bodies.slot_pending = -1;
    h->domains = &s->total;
    h->material_count = w->material_count;
    h->wall_count = w->wall_count;
    memcpy(h->materials, w->materials, sizeof h->materials);
    h->clock.time = w->clock.time;           h->clock.steps =
        w->clock.steps;         h->clock.rebuilds = w->clock.rebuilds;
    h->clock.since = w->clock.since;         h->bodies.balance = w->bodies.balance;
    h->clock.last_rebuild = w->clock.steps;  h->margin.skin_auto =
        w->margin.skin_auto; h->margin.skin = w->margin.skin;
    h->clock.dt = w->clock.dt;               h->stage.dt_valid =
        w->stage.dt_valid;   h->stage.primed = w->stage.primed;
    h->clock.assumed_speed = w->clock.assumed_speed;
    h->stage.forces_valid = w->stage.forces_valid && !w->stage.pairs_changed;
    h->pairs = (demi_pair *)demi_hold(h, DEMI_RUN, (size_t)DEMI_MATERIALS*DEMI_MATERIALS,
                                      sizeof(demi_pair));
    h->bodies.pos = (dem_real *)demi_hold(h, DEMI_RUN, most, 4*sizeof(dem_real));
    h->bodies.vel = (dem_real *)demi_hold(h, DEMI_RUN, most, 4*sizeof(dem_real));
    h->bodies.inv_mass = (dem_real *)demi_hold(h, DEMI_RUN, most, sizeof(dem_real));
    h->bodies.material = (int32_t *)demi_hold(h, DEMI_RUN, most, sizeof(int32_t));
    s->value_room = n*DEMI_SLAB_BINS + 2*DEMI_MATERIALS + 8;
    s->values = (double *)demi_hold(h, DEMI_RUN, s->value_room, sizeof(double));
    s->borders = (double *)demi_hold(h, DEMI_RUN, n + 1, sizeof(double));
    s->slabs = (demi_slab *)demi_hold(h, DEMI_RUN, (size_t)s->local, sizeof(demi_slab));
    if (!h->pairs || !h->bodies.pos || !h->bodies.vel || !h->bodies.inv_mass ||
        !h->bodies.material || !s->values ||
        !s->borders || !s->slabs) return 0;
    memcpy(h->pairs, w->pairs, (size_t)DEMI_MATERIALS*DEMI_MATERIALS*sizeof(demi_pair));
    return demi_slabs_feeds_copy(h, w);
}
/* First borders: the same number of grains in every slab. */
static void demi_slabs_first_borders(dem_slabs *s, const dem_world *w) {
    const int n = DEMI_SLAB_BINS*s->count;
    double ends[2] = {-1e300, -1e300}, lo[3], hi[3];
    int k;
    demi_domain_limits(w, lo, hi);
    s->borders[0] = s->ring ? lo[s->axis] : -1e300;
    s->borders[s->count] = s->ring ? hi[s->axis] : 1e300;
    demi_slabs_extent(s, w, ends);
    if (s->ring) { ends[0] = hi[s->axis]; ends[1] = -lo[s->axis]; }
    if (!(ends[0] > -ends[1])) { ends[0] = w->bodies.count ? ends[0] + 1e-3 : 1; ends[1] = 0; }
    for (k = 0; k < n; k++) s->values[k] = 0;
    demi_slabs_bin(s, w, 1, s->values, n, -ends[1], ends[0]);
    demi_slabs_lay(s, s->values, n, -ends[1], ends[0]);
}

DEM_API void dem_slabs_destroy(dem_slabs *s) {
    dem_allocator allocator;
    int k;
    if (!s) return;
    for (k = 0; k < s->local && s->slabs; k++) dem_world_destroy(s->slabs[k].world);
    allocator = s->head.desc.allocator;
    demi_free_chain(&s->head, DEMI_RUN);
    demi_raw_free(&allocator, s, sizeof *s);
}
DEM_API dem_slabs *dem_slabs_create(dem_world *w, const dem_slabs_desc *desc) {
    if (demi_null(w, "dem_slabs_create", desc, "desc")) return 0;
    const size_t slots = (size_t)w->bodies.slot_count + 1;
    dem_slabs *s;
    uint8_t *marks;
    int k, ok;
    if (demi_unbuilt(w, "dem_slabs_create") != DEM_OK || demi_slabs_check(w, desc) != DEM_OK)
        return 0;
    /* the world keeps its list: it is only read */
    if (w->stage.list_valid && !demi_carry_collect(w)) {
        demi_no_memory(w, "dem_slabs_create");
        return 0;
    }
    s = (dem_slabs *)demi_raw_alloc(&w->desc.allocator, sizeof *s);
    if (!s) { demi_no_memory(w, "dem_slabs_create"); return 0; }
    memset(s, 0, sizeof *s);
    s->head.desc = w->desc;
    s->desc = *desc;
    s->axis = desc->axis;
    s->count = desc->count;
    s->first = desc->first;
    s->local = desc->local ? desc->local : desc->count;
    s->ring = s->count > 1 && w->desc.boundary[s->axis] == DEM_BOUNDARY_PERIODIC;
    s->period = (double)demi_periods_of(w).period[s->axis];
    marks = (uint8_t *)demi_alloc(w, slots, 1);
    ok = marks && demi_slabs_head(s, w);
    s->slots = s->told = s->dealt = w->bodies.slot_count;
    ok = ok && DEMI_GROW(&s->head, s->known, slots);
    for (k = 0; k < w->bodies.slot_count && ok; k++)
        s->known[k] = w->bodies.slot_index[k] < 0 ? 0 : w->bodies.slot_generation[k];
    if (ok) demi_slabs_first_borders(s, w);
    for (k = 0; k < s->local && ok; k++) {
        demi_slab *b = &s->slabs[k];
        b->index = s->first + k;
        b->world = demi_slab_world(s, w, b->index, k ? s->slabs[0].world : 0,
                                   &s->head.desc.allocator);
        ok = demi_slab_ready(b->world, w) && demi_slab_fill(s, b, w, marks);
    }
    demi_free(w, marks);
    if (demi_slabs_same(s, w, ok) == DEM_OK) return s;
    dem_slabs_destroy(s);
    return 0;
}

/* --- collect --- */

/* What a slab has besides grains and memory; then come the walls' loads, fields, outlets, a
   message. */
typedef struct demi_slab_sums {
    int32_t index, walls;
    uint64_t size, left;                        /* bytes of all of it; grains gone by outflow */
    double energy[DEMI_ENERGIES], removed, inserted, throughput, overlap_max;
} demi_slab_sums;

/* All that one slab holds, as one message. */
static int demi_slab_report(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world, *h = &s->head;
    demi_message *out = &s->mine;
    const size_t start = out->size;
    demi_slab_sums sums;
    int i, ok;
    memset(&sums, 0, sizeof sums);
    sums.index = b->index;
    sums.walls = w->wall_count;
    sums.left = w->bodies.balance.left;
    memcpy(sums.energy, w->booked.energy, sizeof sums.energy);
    sums.removed = w->booked.removed;
    sums.inserted = w->booked.inserted;
    sums.throughput = w->booked.throughput;
    sums.overlap_max = w->booked.overlap_max;
    ok = demi_message_put(h, out, &sums, sizeof sums);
    for (i = 0; i < w->wall_count && ok; i++)
        ok = demi_message_put(h, out, &w->walls[i].loads, sizeof(dem_wall_loads));
    for (i = 0; i < w->field_count && ok; i++) {
        const demi_field *f = &w->fields[i];
        const size_t n = demi_field_cells(f)*sizeof(double);
        ok = demi_message_put(h, out, f->solid, n) && demi_message_put(h, out, f->mass, n) &&
             demi_message_put(h, out, f->momentum, 3*n);
    }
    for (i = 0; i < w->outlet_count && ok; i++)
        ok = demi_message_put(h, out, &demi_outlet_at(w, i)->state, sizeof(dem_outlet_state));
    ok = ok && (!w->stage.list_valid || demi_carry_collect(w)) &&
         demi_pack(h, w, w->bodies.ghost, DEMI_ALL, 1, s->axis, 0, out);
    if (!ok) return 0;
    sums.size = out->size - start;
    memcpy(out->bytes + start, &sums, sizeof sums);
    return 1;
}
/* Reports of all processes, passed round the ring: each hands on what it got from below. */
static dem_result demi_slabs_gather(dem_slabs *s) {
    demi_slab *low = &s->slabs[0], *top = &s->slabs[s->local - 1];
    double processes = 1;
    dem_result result = demi_slabs_reduce(s, &processes, 1, 1);
    /* of a step, to be put back */
    const size_t sent = top->out[1].size, below = low->in[0].size, above = top->in[1].size;
    int round, k;
    s->mine.size = s->all.size = 0;
    for (k = 0; k < s->local; k++)
        if (s->slabs[k].result == DEM_OK && !demi_slab_report(s, &s->slabs[k]))
            s->slabs[k].result = demi_no_memory(s->slabs[k].world, "dem_slabs_collect");
    top->out[1].size = 0;
    if (!demi_message_put(&s->head, &s->all, s->mine.bytes, s->mine.size) ||
        !demi_message_put(top->world, &top->out[1], s->mine.bytes, s->mine.size))
        top->result = demi_no_memory(top->world, "dem_slabs_collect");
    if (result == DEM_OK) result = demi_slabs_agree(s, 0, 0);
    for (round = 1; round < (int)processes && result == DEM_OK; round++) {
        result = demi_slabs_exchange(s, DEMI_UP, 0);
        if (result != DEM_OK) break;
        top->out[1].size = 0;
        if (!demi_message_put(&s->head, &s->all, low->in[0].bytes, low->in[0].size) ||
            !demi_message_put(top->world, &top->out[1], low->in[0].bytes, low->in[0].size))
            top->result = demi_no_memory(top->world, "dem_slabs_collect");
        result = demi_slabs_agree(s, 0, 0);
    }
    top->out[1].size = sent;
    low->in[0].size = below;
    top->in[1].size = above;
    return result;
}
/* The report of one slab; null when it is missing. */
static const char *demi_slabs_find(const dem_slabs *s, int index, demi_slab_sums *sums) {
    const char *from = s->all.bytes, *end = from + s->all.size;
    for (; from < end; from += sums->size) {
        memcpy(sums, from, sizeof *sums);
        if (sums->index == index) return from + sizeof *sums;
    }
    return 0;
}
/* What one slab's outlet has let out, on top of the others'. */
static const char *demi_outlet_add(demi_outlet *o, const char *from) {
    dem_outlet_state *to = &o->state, part;
    int k;
    demi_unpack(&from, &part, sizeof part);
    for (k = 0; k < DEM_CLASSES; k++) {
        to->count[k] += part.count[k];
        to->mass[k] += part.mass[k];
    }
    to->total += part.total;
    to->total_mass += part.total_mass;
    to->sorted += part.sorted;
    to->sorted_mass += part.sorted_mass;
    to->gangue += part.gangue;
    to->gangue_mass += part.gangue_mass;
    to->last = DEMI_MAX(to->last, part.last);
    return from;
}
/* Adds a slab's sums to the world's, which were cleared before. Answers where its message
   begins. */
static const char *demi_slabs_add(dem_world *w, const demi_slab_sums *sums, const char *from) {
    int i, k;
    for (i = 0; i < DEMI_ENERGIES; i++) w->booked.energy[i] += sums->energy[i];
    w->booked.removed += sums->removed;
    w->booked.inserted += sums->inserted;
    w->booked.throughput += sums->throughput;
    w->bodies.balance.left += sums->left;
    w->booked.overlap_max = DEMI_MAX(w->booked.overlap_max, sums->overlap_max);
    for (i = 0; i < sums->walls; i++) {
        dem_wall_loads *c = &w->walls[i].loads, part;
        demi_unpack(&from, &part, sizeof part);
        c->force = demi_add(c->force, part.force);
        c->torque = demi_add(c->torque, part.torque);
        c->torque_axial += part.torque_axial;
        c->power += part.power;
        c->contacts += part.contacts;
        for (k = 0; k < 3; k++) c->impulse[k] += part.impulse[k];
        c->torque_impulse += part.torque_impulse;
        c->work += part.work;
        c->time = part.time;
    }
    for (i = 0; i < w->field_count; i++) {
        demi_field *f = &w->fields[i];
        const size_t cells = demi_field_cells(f);
        size_t n;
        for (n = 0; n < 5*cells; n++) {
            double part;
            demi_unpack(&from, &part, sizeof part);
            if (n < cells) f->solid[n] += part;
            else if (n < 2*cells) f->mass[n - cells] += part;
            else f->momentum[n - 2*cells] += part;
        }
    }
    for (i = 0; i < w->outlet_count; i++) from = demi_outlet_add(demi_outlet_at(w, i), from);
    return from;
}
/* From a slab's sums to its grains. */
static const char *demi_slabs_skip(const dem_world *w, const demi_slab_sums *sums,
                                   const char *from) {
    int i;
    from += (size_t)sums->walls*sizeof(dem_wall_loads);
    for (i = 0; i < w->field_count; i++) from += 5*demi_field_cells(&w->fields[i])*sizeof(double);
    return from + (size_t)w->outlet_count*sizeof(dem_outlet_state);
}
/* Time, step, and what else is the same in all slabs. */
static void demi_slabs_common(const dem_slabs *s, dem_world *w) {
    const dem_world *h = &s->head, *from = s->slabs[0].world;
    int i;
    w->clock.time = h->clock.time;           w->clock.steps =
        h->clock.steps;         w->clock.rebuilds = h->clock.rebuilds;
    w->clock.since = h->clock.since;
    w->clock.last_rebuild = h->clock.last_rebuild;                        w->margin.skin_auto =
        h->margin.skin_auto;
    if (s->count == 1) w->margin.skin_auto = from->margin.skin_auto;
    w->margin.skin = h->margin.skin;           w->clock.dt =
        h->clock.dt;               w->stage.dt_valid = h->stage.dt_valid;
    w->clock.assumed_speed = h->clock.assumed_speed;                      w->stage.primed =
        h->stage.primed;
    w->booked.speed_max = h->booked.speed_max; w->stage.moved =
        h->stage.moved;         w->stage.synced = from->stage.synced;
    w->clock.half_kick = from->clock.half_kick;
    w->margin.gone = h->margin.gone;         w->margin.walls_gone = h->margin.walls_gone;
    w->stage.forces_valid = h->stage.forces_valid;
    w->bodies.balance.left = 0;
    w->booked.removed = w->booked.inserted = w->booked.throughput = w->booked.overlap_max = 0;
    memset(w->booked.energy, 0, sizeof w->booked.energy);
    for (i = 0; i < w->wall_count; i++) {
        memset(&w->walls[i].loads, 0, sizeof w->walls[i].loads);
        w->walls[i].pose = from->walls[i].pose;
        w->walls[i].mid = from->walls[i].mid;
    }
    for (i = 0; i < w->outlet_count; i++) demi_outlet_clear(demi_outlet_at(w, i));
    for (i = 0; i < w->feed_count; i++) {
        const dem_feed_desc desc = w->feeds[i].desc;           /* pointers are the world's own */
        w->feeds[i] = h->feeds[i];
        w->feeds[i].desc = desc;
    }
    for (i = 0; i < w->field_count; i++) {
        demi_field *f = &w->fields[i];
        const size_t n = demi_field_cells(f)*sizeof(double);
        memset(f->solid, 0, n);
        memset(f->mass, 0, n);
        memset(f->momentum, 0, 3*n);
        f->samples = from->fields[i].samples;
        f->next = from->fields[i].next;
    }
}
/* Grains, memory and contacts of one slab; those that were fed since are new in the world. */
static void demi_slabs_write(dem_world *w, int32_t *add, uint8_t *seen, const char *from) {
    demi_message_head head;
    int i;
    demi_unpack(&from, &head, sizeof head);
    for (i = 0; i < head.grains; i++) {
        const uint32_t slot = demi_grain_slot(from);
        if (w->bodies.slot_index[slot] < 0) {
            w->bodies.slot_index[slot] = w->bodies.count++;
            w->bodies.balance.present++;
        }
        demi_grain_unpack(w, w->bodies.slot_index[slot], &from);
        seen[slot] = 1;
    }
    w->lll_valid = 0;
    demi_filed_unpack(w, add, &head, from);
}
/* Slots of grains that were fed since the world was told the last time, nobody's as yet. */
static void demi_slabs_slots(const dem_slabs *s, dem_world *w) {
    for (; w->bodies.slot_count < s->slots; w->bodies.slot_count++) {
        w->bodies.slot_generation[w->bodies.slot_count] = 1;
        w->bodies.slot_index[w->bodies.slot_count] = -1;
    }
}
/* Those from `first` on whose grains have gone again are free. */
static void demi_slabs_slots_free(dem_world *w, const uint8_t *seen, int first) {
    int slot;
    for (slot = w->bodies.slot_count - 1; slot >= first; slot--) {
        if (seen[slot]) continue;
        w->bodies.slot_generation[slot]++;
        w->bodies.slot_index[slot] = -2 - w->bodies.slot_free;
        w->bodies.slot_free = slot;
    }
}
/* Room for all that was gathered, and whether the world can hold it. */
static dem_result demi_slabs_room(dem_slabs *s, dem_world *w, int32_t **add, uint8_t **seen) {
    const char *call = "dem_slabs_collect";
    dem_world *h = &s->head;
    demi_slab_sums sums;
    demi_message_head come = {0, 0, 0, 0};
    int k, i;
    if (w->bodies.orienting != s->slabs[0].world->bodies.orienting)
        return demi_fail(h, DEM_ERROR_ARGUMENT, "%s: bodies have orientations in %s only; collect "
                         "into the world the slabs were created from, unchanged, or one built like "
                         "it", call, w->bodies.orienting ? "the world" : "the slabs");
    if (w->bodies.slot_count < s->dealt || w->wall_count != h->wall_count ||
        w->material_count != h->material_count || w->feed_count != h->feed_count ||
        w->field_count != s->slabs[0].world->field_count ||
        w->outlet_count != s->slabs[0].world->outlet_count)
        return demi_fail(h, DEM_ERROR_ARGUMENT, "%s: the world has %d slots, %d walls, %d "
                         "materials, %d feeds, the slabs %d, %d, %d, %d; collect into the world "
                         "they were created from, unchanged, or one built like it", call,
                         w->bodies.slot_count, w->wall_count, w->material_count, w->feed_count,
                         s->dealt, h->wall_count, h->material_count, h->feed_count);
    for (i = 0; i < w->bodies.count; i++) {
        const uint32_t slot = w->bodies.slot[i];
        if ((int)slot >= s->told || w->bodies.slot_generation[slot] != s->known[slot])
            return demi_fail(h, DEM_ERROR_ARGUMENT, "%s: body %u was added to the world after the "
                             "slabs had been created; collect before adding grains, or create the "
                             "slabs anew after it", call, (unsigned)slot + 1);
    }
    for (k = 0; k < s->count; k++) {
        const char *from = demi_slabs_find(s, k, &sums);
        demi_message_head head;
        if (!from)
            return demi_fail(h, DEM_ERROR_STOPPED, "%s: slab %d did not report; see that every "
                             "process makes the call and the ring is closed", call, k);
        from = demi_slabs_skip(w, &sums, from);
        demi_unpack(&from, &head, sizeof head);
        come.pairs += head.pairs;
        come.contacts += head.contacts;
        if (head.pairs) come.stride = head.stride;
        for (i = 0; i < head.grains; i++) {
            const uint32_t slot = demi_grain_slot(from);
            from += demi_body_size(w);
            if ((int)slot < w->bodies.slot_count && w->bodies.slot_index[slot] < 0)
                return demi_fail(h, DEM_ERROR_ARGUMENT, "%s: body %u is in slab %d, but no longer "
                                 "in the world; collect before removing grains, or create the "
                                 "slabs anew after it", call, (unsigned)slot + 1, k);
        }
    }
    if (!demi_list_drop(w)) return demi_no_memory(h, call);
    for (k = 0; k < DEMI_DOMAINS; k++) w->domains[k].kept = 0;
    w->filed.count = 0;
    i = w->bodies.slot_count;
    if (!DEMI_GROW(h, *seen, (size_t)s->slots + 1) ||
        !demi_bodies_reserve(w, (size_t)w->bodies.count + (size_t)DEMI_MAX(s->slots - i, 0)))
        return demi_no_memory(h, call);
    demi_slabs_slots(s, w);
    if (!demi_filed_reserve(w, add, &come)) {
        w->bodies.slot_count = i;
        return demi_no_memory(h, call);
    }
    memset(*seen, 0, (size_t)s->slots + 1);
    return DEM_OK;
}
DEM_API dem_result dem_slabs_collect(dem_slabs *s, dem_world *w) {
    if (!s || demi_null(&s->head, "dem_slabs_collect", w, "world")) return DEM_ERROR_ARGUMENT;
    int32_t *add = 0;
    uint8_t *seen = 0;
    dem_result result = demi_slabs_usable(s, "dem_slabs_collect");
    const int slots = w->bodies.slot_count;
    demi_slab_sums sums;
    int k, i;
    if (result == DEM_OK) result = demi_slabs_gather(s);
    if (result == DEM_OK) result = demi_slabs_room(s, w, &add, &seen);
    if (result == DEM_OK) {
        demi_slabs_common(s, w);
        for (k = 0; k < s->count; k++) {
            const char *from = demi_slabs_find(s, k, &sums);
            from = demi_slabs_add(w, &sums, from);
            demi_slabs_write(w, add, seen, from);
        }
        demi_slabs_slots_free(w, seen, slots);
        s->told = s->slots;
        /* in no slab: left through an outflow boundary or an outlet */
        for (i = w->bodies.count - 1; i >= 0; i--)
            if (!seen[w->bodies.slot[i]]) {
                const double removed = w->booked.removed;
                demi_body_take_out(w, i);
                w->booked.removed = removed;
            }
        /* whatever happened here since */
        w->bodies.balance.inserted = s->head.bodies.balance.inserted;
        w->bodies.balance.removed = s->head.bodies.balance.removed;
        demi_effects(w);                        /* the world may never have taken a step itself */
        demi_kernel_choose(w);
    }
    demi_free(w, add);
    demi_free(&s->head, seen);
    return result;
}
DEM_API void dem_slabs_loads_reset(dem_slabs *s) {
    if (!s) return;
    int k, i;
    for (k = 0; k < s->local; k++) {
        dem_world *w = s->slabs[k].world;
        w->booked.overlap_max = 0;
        for (i = 0; i < w->wall_count; i++) {
            dem_wall_loads *c = &w->walls[i].loads;
            memset(c->impulse, 0, sizeof c->impulse);
            c->torque_impulse = c->work = c->time = 0;
        }
    }
}

DEM_API const char *dem_slabs_error(const dem_slabs *s) {
    return s ? s->head.error : "dem_slabs_create: returned null; dem_world_error(world) says why";
}
DEM_API dem_result dem_slab_get(const dem_slabs *s, int index, dem_slab *out) {
    if (!s || demi_null(&s->head, "dem_slab_get", out, "slab")) return DEM_ERROR_ARGUMENT;
    const demi_slab *b;
    if (index < s->first || index >= s->first + s->local)
        return demi_fail((dem_world *)&s->head, DEM_ERROR_ARGUMENT, "dem_slab_get: slab %d is not "
                         "here, this process holds %d to %d of %d; ask the process that holds it",
                         index, s->first, s->first + s->local - 1, s->count);
    b = &s->slabs[index - s->first];
    out->grains = b->world->bodies.count - b->ghost_count;
    out->ghosts = b->ghost_count;
    out->lo = s->borders[index];
    out->hi = s->borders[index + 1];
    out->work = b->work;
    out->seconds = b->seconds;
    out->bytes = b->bytes;
    return DEM_OK;
}
DEM_API dem_slabs_counters dem_slabs_counters_get(const dem_slabs *s) {
    dem_slabs_counters c;
    int k;
    memset(&c, 0, sizeof c);
    if (!s) return c;
    c.time = s->head.clock.time;
    c.steps = s->head.clock.steps;
    c.rebuilds = s->head.clock.rebuilds;
    c.border_moves = s->border_moves;
    for (k = 0; k < s->local; k++) c.migrated += s->slabs[k].migrated;
    c.skin = (dem_real)s->head.margin.skin;
    c.dt = s->head.clock.dt;
    return c;
}

#if defined(__clang__)
#pragma STDC FP_CONTRACT DEFAULT
#elif defined(__GNUC__) && !defined(__TINYC__)
#pragma GCC pop_options
#endif
#endif /* DEM_IMPLEMENTATION */

/* MIT License

   Copyright (c) 2026 the dem.h authors

   Permission is hereby granted, free of charge, to any person obtaining a copy
   of this software and associated documentation files (the "Software"), to deal
   in the Software without restriction, including without limitation the rights
   to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
   copies of the Software, and to permit persons to whom the Software is
   furnished to do so, subject to the following conditions:

   The above copyright notice and this permission notice shall be included in all
   copies or substantial portions of the Software.

   THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
   IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
   FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
   AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
   LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
   OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE
   SOFTWARE.
*/
