/* ---------------------------------------------------------------------------------------------
   >>run
   What a program does with a scene: check it, run it, measure it, compare choices, read and write
   files, record a replay, save and restore it, divide it among processors, print a report.
   --------------------------------------------------------------------------------------------- */

/* Errors in this part. A function that returns a dem_result returns DEM_OK, or an error code after
   it has stored an error message (dem_world_error_get). Instead of a pointer or an id a failing
   function returns null or a zero id; instead of a count it returns -1. A failing call changes
   nothing, unless the comment says so. Other functions that return a number or a struct return
   zeros for a null world. These reasons are not repeated below:
       DEM_ERROR_ARGUMENT  a null pointer, an id that names nothing, a value outside the range given
                           here or not finite, or a call that user-defined functions may not make
       DEM_ERROR_MEMORY    the allocator returned null
       DEM_ERROR_FILE      a file cannot be opened, read or written
       DEM_ERROR_FORMAT    the contents of a file do not follow its format
   An argument or field may be null only where "or null" is written. */

/* ---- before a run: time step, mistakes ---- */

/* The time step that a scene allows, and what limits it. */
typedef struct dem_advice {
    /* s, the proposed step: contact_time/50, or a fifth of the largest stable step if less */
    dem_real dt;
    /* s, the largest step that a run accepts: contact_time/20 [ALK07] eq 2.22, or the largest
       stable step if less. Stability is that of contacts to come, with their dashpots, friction and
       rolling resistance. */
    dem_real dt_max;
    dem_real contact_time;    /* s, duration of the shortest contact */
    /* s, the smallest Rayleigh time pi R sqrt(rho/G)/(0.1631 nu + 0.8766) of the smallest grains of
       each material; for comparison only */
    dem_real rayleigh;
    /* m/s, the impact speed assumed: desc.impact_speed; if that is 0, the largest of the speeds of
       grains, feeds and walls and of a fall through the height of the scene, at least 1e-3 */
    dem_real speed;
    char binds[160];          /* the contact that limits the step: materials, radii, speed */
} dem_advice;
/* Computes the time step that the scene allows as it is now, feeds included. It considers contacts
   to come. Contacts that are already compressed are examined when a run begins, and at least every
   1000 steps later (every eight with desc.law_rate). If the step is too large for them, a given
   desc.dt makes dem_world_step return DEM_ERROR_TIME_STEP, and a chosen step is made smaller. An
   error if no grain can move, or with DEM_RESPONSE_IMPULSES, where contacts have no duration. */
DEM_API dem_result dem_step_advice_get(const dem_world *world, dem_advice *advice);

/* How serious a finding of dem_world_check is. */
typedef enum dem_severity {
    DEM_SEVERITY_NOTE = 1,     /* possibly not intended */
    DEM_SEVERITY_WARNING,      /* most likely not intended */
    DEM_SEVERITY_ERROR         /* the scene will not run, or makes no sense */
} dem_severity;
/* One likely mistake in a scene. */
typedef struct dem_finding {
    dem_severity severity;
    char text[240];            /* what is wrong, its value, the likely cause, the remedy */
} dem_finding;
/* Looks for likely mistakes before a scene runs, and returns how many it found (0 if the call
   fails). Writes at most `capacity` findings, the most severe first; `findings` or null. Nothing
   moves; the neighbour list is rebuilt if it is out of date. It reports
   - grains that overlap each other or a wall by more than 1 % of their radius;
   - grains inside a closed mesh, profile or surface of revolution while others are outside, also
     grains that feeds will insert. A container that holds all grains is not reported. A mesh is
     closed if each edge has two triangles; walls that move together count as one mesh;
   - overlaps above 5 % of a radius to be expected from speed or weight, with the modulus that would
     keep them below 1 %;
   - values that suggest units other than m, kg/m3 and Pa;
   - positions so far from the origin that their last digits do not resolve overlaps;
   - scenes in which nothing moves, or grains fall for ever;
   - grains outside an outflow boundary, walls that no grain can reach, materials without use;
   - a time step that is too large, or 20 times smaller than necessary. */
DEM_API int dem_world_check(dem_world *world, dem_finding *findings, int capacity);
/* Prints the first 16 findings of dem_world_check, one per line (nothing if there are none), and
   returns how many it found. */
DEM_API int dem_world_check_print(dem_world *world, FILE *out);

/* ---- run ---- */

/* Advances the world by `steps` time steps (>= 0), or to the first step that fails. The error
   message names that step; the steps before it are kept. The first step is not taken while the
   error message of a call that builds the scene is unread (dem_world_error_get). Errors:
       DEM_ERROR_TIME_STEP  the step is too large for the contacts, or a body or wall would move by
                            more than the smallest radius (a body under impulses: by more than this
                            and more than half the range below which contacts are solved)
       DEM_ERROR_UNSTABLE   a position, velocity or force is not finite, or two bodies overlap by
                            the smaller radius
       DEM_ERROR_STOPPED    an output stopped the run; or desc.unsolved_stops is 1 and the sweeps of
                            a step did not reach the tolerance
       DEM_ERROR_MEMORY     The bodies may have moved already; the step then counts as taken. The
                            next call completes it first, here or in a world that has read a
                            checkpoint written meanwhile. The bits are those of a run without the
                            interruption. */
DEM_API dem_result dem_world_step(dem_world *world, int steps);
/* Receives the progress of a run, about ten times per second of wall time and once at the end.
   done: fraction, 0 to 1. seconds_left: estimated wall time, s. A non-zero return value stops the
   run with DEM_ERROR_STOPPED and leaves the state intact; at the end it has no effect. */
typedef int (*dem_progress_fn)(const dem_world *world, double done, double seconds_left,
                               void *user);
/* Advances the world by `seconds` of simulated time (>= 0), to the nearest step. Consecutive calls
   add up: twenty of 0.05 s end within half a step of 1 s, because each counts from where the
   previous one should have ended (unless other steps were taken in between). progress: or null.
   Errors as for dem_world_step. */
DEM_API dem_result dem_world_run(dem_world *world, double seconds, dem_progress_fn progress,
                                 void *user);
/* Advances the world to a time of its clock, s, not before the present one. Otherwise as
   dem_world_run. A program that has read a checkpoint can thus run to the same end. */
DEM_API dem_result dem_world_run_to(dem_world *world, double time, dem_progress_fn progress,
                                    void *user);
/* Advances the world until its bodies are at rest, for at most `seconds` of simulated time (> 0).
   At rest: at three checks in a row the root mean square speed, weighted by mass, is below `speed`,
   and no body is faster than 10 times that. Spins do not count, because nothing brakes a sphere
   that spins on a point. Checks are at most sqrt(R/g) apart, the time of a fall by half the mean
   radius R (without gravity: the time in which `speed` covers R/2). All feeds, also those that
   begin later, must have inserted all their grains first.
   speed: m/s, >= 0; 0: 0.01 sqrt(2 g R), which needs gravity. progress: or null.
   Errors as for dem_world_step; also DEM_ERROR_ARGUMENT for a feed with neither `limited` nor
   `end`, and DEM_ERROR_STOPPED if the time is up: the message gives the speeds, or the feed that is
   not done, and the state is intact. */
DEM_API dem_result dem_world_settle(dem_world *world, double seconds, dem_real speed,
                                    dem_progress_fn progress, void *user);
/* Prints the progress of a run to the FILE that is passed as user, and returns 0: a progress
   function. On a terminal it rewrites one line; in a file it adds a line for every tenth of the
   run. */
DEM_API int dem_progress_print(const dem_world *world, double done, double seconds_left,
                               void *user);

/* Sets gravity, m/s2 (components up to 1e15), from now on: for a mill seen from its shell, or a
   table that is tilted. Any number of calls between two steps is allowed. A planar world ignores z.
   dem_world_desc_get returns it, checkpoints store it, and slabs take it over when they are
   created. */
DEM_API dem_result dem_world_gravity_set(dem_world *world, dem_vec3 gravity);

/* Sets the time step, s (1e-20 to 1e15), from now on. 0: chosen from the scene, as with desc.dt; an
   error with DEM_RESPONSE_IMPULSES. Contact history stays. Checkpoints store the step. If it is too
   large, the next dem_world_step returns DEM_ERROR_TIME_STEP. */
DEM_API dem_result dem_world_dt_set(dem_world *world, dem_real dt);

/* Returns the simulated time, s. */
DEM_API double dem_world_time_get(const dem_world *world);
/* Returns the number of steps taken. */
DEM_API uint64_t dem_world_steps_get(const dem_world *world);
/* Returns a 64-bit digest of the state: time, positions, orientations, velocities, spins, walls,
   joints, feeds, outlets and contact history. Equal runs have equal digests. */
DEM_API uint64_t dem_world_hash_get(const dem_world *world);

/* Counters of a world. Checkpoints store them. */
typedef struct dem_counters {
    uint64_t steps, rebuilds;   /* steps taken; rebuilds of the neighbour list */
    /* of the last step: candidate pairs of bodies; contacts between bodies; contacts with walls. A
       contact of polyhedra counts once. With impulses a contact counts if its impulse is not 0. */
    int candidates, contacts, wall_contacts;
    /* largest overlap since the last reset, over the smaller radius (of other shapes: over the
       smaller half width along the normal). A run stops at 1. */
    dem_real overlap_max;
    dem_real speed_max;         /* m/s, of the fastest body, at the last step */
    dem_real skin;              /* m, in use */
    dem_real dt;                /* s, in use */
    dem_search search;          /* in use */
    int threads, domains;       /* OpenMP threads; work groups (see the glossary) */
    int sweeps;                 /* impulses: sweeps of the last step */
    /* impulses: m/s, largest and root mean square change of a contact velocity in the last sweep of
       the last step; compare desc.tolerance */
    dem_real residual, residual_rms;
    uint64_t unsolved;          /* impulses: steps whose sweeps did not reach the tolerance */
    size_t memory;              /* bytes allocated by the world */
} dem_counters;
/* Returns the counters. */
DEM_API dem_counters dem_counters_get(const dem_world *world);
/* Sets the counter overlap_max to 0, for instance after a scene has been built. */
DEM_API void dem_overlap_max_reset(dem_world *world);

/* The account of energy, J, since the world was created; zeros unless desc.ledger is 1.
       residual = kinetic + rotational + elastic - gravity - walls - force - inserted + removed
                  + normal + slide + tangent + rolling
   The residual is the error of the time integration; compare it with `throughput`. Potential energy
   is not stored energy here: `gravity` is the work of gravity. If a user-defined law never fills
   force->energy, the ledger cannot separate what the law stores from what it dissipates: `unknown`
   then holds the residual, and `residual` is 0. */
typedef struct dem_ledger {
    double kinetic, rotational, elastic;    /* stored now */
    /* supplied: work of gravity; of moving walls and motors; of force fields; kinetic energy of
       inserted bodies */
    double gravity, walls, force, inserted;
    /* dissipated: by normal dashpots, hysteresis, impacts and joints; by sliding; by tangential
       dashpots; by rolling resistance */
    double normal, slide, tangent, rolling;
    double removed;                         /* kinetic energy of removed bodies */
    double throughput;                      /* sum of the magnitudes of what was supplied */
    double residual;
    double unknown;                         /* > 0: the user-defined law created energy */
} dem_ledger;
/* Returns the ledger. */
DEM_API dem_ledger dem_ledger_get(const dem_world *world);
/* Totals over all bodies that can move. */
typedef struct dem_totals {
    double mass, kinetic, rotational;       /* kg; J; J */
    /* centre of mass, m; momentum, kg m/s; angular momentum about the origin, kg m2/s */
    double centre[3], momentum[3], angular[3];
} dem_totals;
/* Computes the totals in one pass over the bodies. */
DEM_API dem_totals dem_totals_get(const dem_world *world);

/* ---- trials: what accuracy costs in your scene ---- */

/* Returns one number by which a world is judged, an observable. Averages over many grains or a long
   time are good observables. Positions are not: once grains collide, they depend on round-off. */
typedef double (*dem_observer_fn)(const dem_world *world, void *user);
/* Returns the height of the centre of mass above the origin, m: against gravity, or along z if
   there is none. user: not used, or null, as in the next three. */
DEM_API double dem_observer_height(const dem_world *world, void *user);
/* Returns the kinetic energy of all bodies that can move, rotation included, J. */
DEM_API double dem_observer_kinetic(const dem_world *world, void *user);
/* Returns the mean number of contacts per body, walls included. A contact of two bodies counts for
   both. */
DEM_API double dem_observer_contacts(const dem_world *world, void *user);
/* Returns the sum over all walls of the magnitude of the force on each, N. */
DEM_API double dem_observer_walls(const dem_world *world, void *user);

/* Largest numbers of observables and of trials. */
enum { DEM_OBSERVABLES = 8, DEM_TRIALS = 8 };
/* A named observable. */
typedef struct dem_observable {
    const char *name, *unit;       /* `unit` or null; both must outlive the dem_trials */
    dem_observer_fn function;
    void *user;                    /* passed to `function`; or null */
    double scale;                  /* >= 0, divides deviations; 0: the value of the reference */
} dem_observable;
/* How dem_trials_run works. Begin with DEM_TRIALS_DESC. */
typedef struct dem_trials_desc {
    /* s, required, > 0: simulated by each run, at least 64 steps. Observables are averaged over its
       second half. */
    double duration;
    /* s, wall time of all trials, estimated from some steps of the scene; 0 means 60 s. If it is
       too short, the runs simulate less. */
    double budget;
    double tolerance;              /* allowed deviation of an observable/its scale; 0 means 0.02 */
    /* 0 to 16, not 1: runs per trial, which start from positions that differ by at most 1e-6 of a
       radius; 0 means 3 */
    int seeds;
    /* observables to compare; 0 means three. These are height, scaled by its value above the
       lowest grain; kinetic, scaled by the present energy plus that of a fall of all grains by
       their radius; contacts. */
    int observable_count;
    dem_observable observables[DEM_OBSERVABLES];
    /* called with the original world after each trial; null means no call. A non-zero return value
       ends dem_trials_run with DEM_ERROR_STOPPED. */
    dem_progress_fn progress;
    void *user;                    /* passed to `progress`; or null */
} dem_trials_desc;
static const dem_trials_desc DEM_TRIALS_DESC_ZERO = DEM_ZERO;
#define DEM_TRIALS_DESC DEM_TRIALS_DESC_ZERO
/* The result of one trial. */
typedef struct dem_trial {
    const char *name;              /* how the trial differs from the scene */
    /* step: factor on dt/contact_time, dt given or chosen. stiffness: factor on all moduli and
       stiffnesses; normal_damping of a pair is multiplied by its root. */
    double step, stiffness;
    double dt;                     /* s, at the end */
    int done;                      /* runs that reached their end, 0 to seeds */
    double seconds;                /* wall time per simulated second */
    double value[DEM_OBSERVABLES], error[DEM_OBSERVABLES];   /* mean over runs; standard error */
    double drift[DEM_OBSERVABLES]; /* deviation from the reference, over the scale */
    /* every observable is within this of the reference, over its scale: the largest |drift| plus
       the statistical error (95 % for each observable). Infinite if a run did not reach its end. */
    double promise;
    char refusal[200];             /* why a run did not reach its end */
} dem_trial;
/* The results of dem_trials_run. */
typedef struct dem_trials {
    int count, best;               /* trials; index of the best one, 0: the scene as it is */
    int reference;                 /* index of the trial with the smallest step */
    double duration, tolerance;    /* s simulated by each run; tolerance applied */
    int seeds, observable_count;   /* runs per trial; observables */
    dem_observable observables[DEM_OBSERVABLES];
    dem_trial trial[DEM_TRIALS];
    char advice[400];              /* what to do, and why */
} dem_trials;
/* Runs the scene on copies with other choices, compares observables and wall time, and advises
   which choice to take. The world itself does not change. The trials are: the scene as it is; time
   steps twice, half and a quarter as long; grains 10 times softer and 4 times stiffer, with the
   same number of steps per contact; another normal law; another friction law. Trials that do not
   fit the scene are left out. The best trial is the cheapest whose `promise` is within the
   tolerance; a change must save a tenth of the time. If none is, the best is the reference.
   User-defined functions (laws, fields, motions, regions of feeds) are called for the copies, too,
   and may see the same simulated time again.
   Errors: no bodies; DEM_RESPONSE_IMPULSES; a budget too short for 64 steps per run; a scene that
   does not run. A trial that does not reach its end is not an error. */
DEM_API dem_result dem_trials_run(dem_world *world, const dem_trials_desc *desc,
                                  dem_trials *trials);
/* Prints the trials as a table, and the advice. */
DEM_API void dem_trials_print(const dem_trials *trials, FILE *out);

/* ---- contacts ---- */

/* One contact. */
typedef struct dem_contact_info {
    dem_body a, b;                       /* b is null for a contact with a wall */
    int32_t wall;                        /* dem_wall id; 0: b is a body */
    dem_vec3 point, normal;              /* m; unit, from a to b */
    dem_real overlap;                    /* m; < 0: a gap within the range of the law */
    dem_vec3 force;                      /* N, on a */
} dem_contact_info;
/* Writes the contacts of the present state, those with walls included, at most `capacity` of them,
   and returns their number. `out` or null. The contact history does not change. A contact of two
   polyhedra, or of one with a wall, is written as up to four (dem_shape_polyhedron_add). Returns -1
   if bodies or walls have changed since the last step; then call dem_candidates_rebuild first. */
DEM_API int dem_contacts_get(const dem_world *world, dem_contact_info *out, int capacity);
/* Receives one contact and its history. memory: as many reals as desc.law_memory (built-in laws: 0
   to 9; impulses: 11), vectors as seen from a. Values that the function writes there count from the
   next step on. */
typedef void (*dem_contact_fn)(const dem_contact_info *contact, dem_real *memory, void *user);
/* Calls `fn` for every contact, those with walls included, and returns their number. With a law
   that has a range these are all pairs within the range. Computes forces first if the scene has
   changed, and returns -1 where a step would fail. user: or null. */
DEM_API int dem_contacts_each(dem_world *world, dem_contact_fn fn, void *user);
/* Calls `make` for every pair of bodies (no walls) with a gap below `gap`, and returns their
   number, so that `make` can write a bond into the contact history of a user-defined law. gap: m,
   >= 0, at most the range of the law for the two smallest grains: law_range + law_range_radii times
   the sum of their radii. user: or null. Errors as for dem_contacts_each. */
DEM_API int dem_bonds_make(dem_world *world, dem_real gap, dem_contact_fn make, void *user);
/* Writes the candidate pairs of the neighbour list (capacity x 2: dem_body.slot of a and b), at
   most `capacity` of them, and returns their number. `out` or null. Returns -1 if bodies or walls
   have changed since the last step. */
DEM_API int dem_candidates_get(const dem_world *world, uint32_t *out, int capacity);
/* Rebuilds the neighbour list now, for tests and analysis. A run does so automatically. */
DEM_API dem_result dem_candidates_rebuild(dem_world *world);

/* ---- measuring ---- */

/* What a servo wall (DEM_MOTION_SERVO) does. Force, speed and distance are along the direction of
   its velocity, in which it presses the grains; a piston of several walls has one state. */
typedef struct dem_servo {
    double target, force;          /* N: force to reach and force on the grains, now */
    double speed, travel;          /* m/s; m, from the pose in which the motion began */
    /* N/m, N s/m: sums over the contacts of the wall when its speed was chosen, at `time` (s). They
       set the gain. The speed changes from u to v with stiffness dt (v - 0.9 u) + damping (v - u) =
       (target - force)/2, and is at most the largest one (>>servo). */
    double stiffness, damping, time;
} dem_servo;
/* Writes the state of a servo wall to servo. */
DEM_API dem_result dem_wall_servo_get(const dem_world *world, dem_wall wall, dem_servo *servo);

/* A field: a grid of cells on which a run averages solid fraction, velocity and, if desired, stress
   over a window of time. A grain counts in the cell of its centre ([MIL] 5.2.9), so cells smaller
   than grains need a long window; or it is spread about its centre by coarse graining (width).
   Begin with DEM_FIELD_DESC. */
typedef struct dem_field_desc {
    dem_box box;              /* m, required: what the cells divide */
    int cells[3];             /* required, >= 1: along each axis, at most 2^28 in all */
    double start, end;        /* s, window of time; end 0 means no end */
    double interval;          /* s, between samples; 0 means every 100 steps */
    dem_material material;    /* only grains of this material; id 0 means all grains */
    dem_real radius_min, radius_max;  /* m, only of these (bounding) radii; max 0 means any */
    int stress;               /* 1: also flux, stress and contacts; visits every contact */
    /* m, of coarse graining; 0 means none. Each grain is then spread by Lucy's function of reach
       c = 2 width [GOL10], 105/(16 pi c^3) (1 + 3 r/c) (1 - r/c)^3 (planar: 5/(pi c^2) in place of
       the first factor), evaluated at the centres of cells. Keep cells no longer than width. */
    dem_real width;
} dem_field_desc;
static const dem_field_desc DEM_FIELD_DESC_ZERO = DEM_ZERO;
#define DEM_FIELD_DESC DEM_FIELD_DESC_ZERO
/* Adds a field, and returns its id. Steps sample it from then on. */
DEM_API dem_field dem_field_add(dem_world *world, const dem_field_desc *desc);
/* The sums of a field over its samples. Cell (i, j, k) has index i + cells[0]*(j + cells[1]*k). The
   pointers are valid until the next step. */
typedef struct dem_field_data {
    int cells[3];
    dem_box box;              /* m */
    uint64_t samples;         /* number of samples */
    const double *solid;      /* cells: sum of the volume of grains over that of the cell */
    const double *mass;       /* cells: sum of masses, kg */
    const double *momentum;   /* cells x 3: sum of momenta, kg m/s; velocity = momentum/mass */
    const double *grains;     /* cells: sum of the number of grains */
    /* null unless desc.stress is 1.
       flux: cells x 6 (xx yy zz xy xz yz), Pa: sum over grains of m v v over the volume of the cell
       stress: cells x 6, Pa, pressure positive: sum over contacts of force x branch over the volume
       of the cell. A contact of two grains acts along the line between their centres, and each
       grain accounts for its half; one with a wall acts from the centre to the contact.
       contacts: cells: sum of the number of contacts of the grains */
    const double *flux, *stress, *contacts;
} dem_field_data;
/* Means of one cell over the samples; 0 where no grain was. */
typedef struct dem_field_cell {
    double grains;            /* number of grains in the cell */
    double solid, density;    /* solid fraction; bulk density, kg/m3 */
    double velocity[3];       /* m/s, weighted by mass */
    double temperature;       /* m2/s2, per axis, about that velocity; 0 unless desc.stress is 1 */
    /* Pa, xx yy zz xy xz yz, pressure positive: of contacts and of motion about that velocity; 0
       unless desc.stress is 1 */
    double stress[6];
    double coordination;      /* contacts per grain, with walls; 0 unless desc.stress is 1 */
} dem_field_cell;
/* Writes pointers to the sums of a field to `data`. */
DEM_API dem_result dem_field_get(const dem_world *world, dem_field field, dem_field_data *data);
/* Computes the means of the cell (i, j, k), which count from 0. */
DEM_API dem_result dem_field_cell_get(const dem_world *world, dem_field field, int i, int j, int k,
                                      dem_field_cell *cell);
/* Sets the sums of a field and its number of samples to 0; the window of time stays. */
DEM_API dem_result dem_field_reset(dem_world *world, dem_field field);

/* The slope of a free surface, against gravity. */
typedef struct dem_repose {
    double angle;             /* rad, of the straight line fitted to the surface */
    double error;             /* rad, its standard error */
    int places;               /* points of the fit: strips that are a mean diameter wide */
} dem_repose;
/* Measures the angle of repose of a heap. It considers grains in `box` (m; both corners 0: all)
   that can move and are connected by gaps below half their mean radius, and takes the heaviest of
   several heaps. Grains that ran away, fell off a table or fly therefore do not count. The surface
   consists of the highest grains by distance from the vertical through the centre of mass. The line
   is fitted from 20 to 80 % of its height, without the rounded top and the toe; in a planar world
   to the mean of both flanks. An error without gravity or with fewer than four points. */
DEM_API dem_result dem_repose_heap_get(const dem_world *world, dem_box box, dem_repose *repose);
/* Measures the dynamic angle of repose in a drum that rotates about `axis` (right-handed, of any
   length, horizontal): positive if the surface rises in the direction in which the bottom of the
   drum moves. The line is fitted to the middle half of the surface. It suits charges that roll or
   cascade; grains in flight belong to no surface. `box` and errors as above. */
DEM_API dem_result dem_repose_drum_get(const dem_world *world, dem_box box, dem_vec3 axis,
                                   dem_repose *repose);

/* ---- files ---- */

/* Defects of a mesh, as counted on reading. They never stop a run. */
typedef struct dem_mesh_health {
    int open_edges;           /* edges with one triangle */
    int crowded_edges;        /* edges with more than two triangles */
    int duplicates;           /* triangles with the same three corners as an earlier one */
    int shells;               /* pieces that are connected by edges with two triangles */
    int flipped;              /* triangles that face another way than most of their shell */
    int twisted_edges;        /* edges of shells that have one side only, like a Moebius strip */
    int slivers;              /* triangles: height below 1e-3 of the longest side, or no area */
    int merged_vertices;      /* vertices merged on reading, because they were equal (STL) */
    int split_faces;          /* faces of more than three corners, cut into triangles (OBJ) */
    int bent_faces;           /* of these: a corner is off their plane by > 1e-3 of their size */
    int crossed_faces;        /* of these: an edge crosses another, or they have no area */
    dem_box box;              /* m, bounds of the mesh */
    char hint[200];           /* a likely mistake of units, or "" */
} dem_mesh_health;
/* Reads the triangles of a file and, if `health` is not null, counts its defects. The contents
   identify the format: STL (text or binary), OBJ, or the text format of [MIL] (counts, vertices,
   corners counted from 1). OBJ faces of more than three corners become triangles that cover them
   once and keep their winding; a face that is not convex may have 10,000 corners. Error messages
   name file, line and reason. Free the mesh with dem_mesh_free. */
DEM_API dem_result dem_mesh_read(dem_world *world, const char *path, dem_mesh *mesh,
                                 dem_mesh_health *health);
/* Reads triangles from memory, `size` bytes at `data`, as dem_mesh_read does. name: for error
   messages; or null. */
DEM_API dem_result dem_mesh_parse(dem_world *world, const char *name, const void *data,
                                  size_t size, dem_mesh *mesh,
                                  dem_mesh_health *health);
/* Reads one named part of a file, such as the shell, the ends or the lifters of a drum. In an STL
   text file this is the solid of that name (the whole rest of its line). In an OBJ file these are
   the faces whose object (`o NAME`) or one of whose groups (`g NAME NAME`) has that name; a `g`
   line replaces the groups before it and leaves the object. If the file has no such part, the error
   message lists its parts. health: or null. */
DEM_API dem_result dem_mesh_part_read(dem_world *world, const char *path, const char *part,
                                      dem_mesh *mesh, dem_mesh_health *health);
/* Frees a mesh that this world has read. */
DEM_API void dem_mesh_free(dem_world *world, dem_mesh *mesh);
/* Scales a mesh about its origin (scale > 0; 1e-3: from mm to m), rotates it about the origin, and
   moves it by `to` (m, components up to 1e15). A rotation of zeros is none; any other length is
   normalised. Call it before the mesh becomes a wall or a shape. */
DEM_API dem_result dem_mesh_place(dem_world *world, dem_mesh *mesh, dem_real scale,
                                  dem_quat rotation, dem_vec3 to);
/* The mass properties of a closed mesh, and how well spheres fit it. */
typedef struct dem_spheres_fit {
    dem_real volume;          /* m3, of the mesh, exact */
    dem_vec3 centre;          /* m, centre of mass of the mesh, exact */
    dem_real inertia[6];      /* m5, of the mesh, exact, as in dem_cluster_desc */
    dem_real volume_error;    /* volume of the union of spheres over that of the mesh, less 1 */
    dem_real inertia_error;   /* the same of the moment that deviates most; computed on the grid */
    dem_real surface_error;   /* m, root mean square distance of the mesh from the union */
    dem_real wrong;           /* volume in only one of the two, over that of the mesh */
} dem_spheres_fit;
/* Approximates a closed mesh by `count` spheres (1 to 1000), for a cluster: writes positions (count
   x 3) and radii (count), in m, in the frame of the mesh. On a grid with 40 points along the
   longest side, each sphere is placed where it leaves the fewest points wrong; then all are placed
   again, one at a time, while that helps. fit: or null. A cluster of few spheres has the mass and
   moments of the body if it gets volume, centre and inertia of `fit` (DEM_CLUSTER_GIVEN).
   Inconsistent winding, a mesh that is inside out, and duplicate triangles do no harm. A shell
   inside another that faces the other way is a cavity. Errors: an open mesh, edges whose triangles
   do not pair, a surface with one side only, shells that cross or that face the same way as the
   shell around them, a mesh too thin for any sphere. */
DEM_API dem_result dem_mesh_spheres(dem_world *world, const dem_mesh *mesh, int count,
                                    dem_real *positions, dem_real *radii, dem_spheres_fit *fit);
/* A named part of a file that becomes a wall. */
typedef struct dem_wall_part {
    const char *name;         /* as for dem_mesh_part_read */
    dem_material material;
    dem_motion motion;        /* DEM_MOTION: the wall stays where it is */
} dem_wall_part;
/* Adds a machine from CAD: `count` (>= 1) named parts of a file (STL text, OBJ), each as a wall
   with its own material and motion. scale: m per unit of length of the file, > 0; 0: 1. walls:
   receives `count` ids; or null. If one part fails, no wall is added. */
DEM_API dem_result dem_wall_parts_add(dem_world *world, const char *path, dem_real scale, int count,
                                 const dem_wall_part *parts, dem_wall *walls);
/* Reads the segments of a profile in the text format of [MIL] in 2-D: the counts of vertices and
   segments, x y per vertex, two corners counted from 1 per segment. Free with dem_profile_free. */
DEM_API dem_result dem_profile_read(dem_world *world, const char *path, dem_profile *profile);
/* Reads the segments of a profile from memory, `size` bytes at `data`. name: for error messages; or
   null. */
DEM_API dem_result dem_profile_parse(dem_world *world, const char *name, const void *data,
                                     size_t size,
                                     dem_profile *profile);
/* Frees a profile that this world has read. */
DEM_API void dem_profile_free(dem_world *world, dem_profile *profile);

/* Spheres, as read from a file. Arrays for which the file has no data are null. */
typedef struct dem_grains {
    int count;
    dem_real *positions, *radii;     /* m, count x 3; m, count */
    dem_real *velocities, *spins;    /* m/s, count x 3; rad/s, count x 3 */
    int32_t *materials;              /* count: numbers of the file, 1: the first material added */
    int lines_left;                  /* dumps and XYZ: lines of later frames, which are not read */
    char ignored[240];               /* names of columns without use, or "" */
} dem_grains;
/* Reads grains from a file. The contents identify the format; lengths are in m:
   - text or CSV, one line per grain. Columns are separated by semicolons, tabs, commas or blanks,
     as in the first line. A decimal comma is allowed between semicolons or tabs. Cells may be
     quoted; # begins a comment. The first line, or a comment before it, names the columns; without
     names they are x y z r, or x y z r vx vy vz. An empty cell in a column that is used is an
     error.
   - extended XYZ with Properties (OVITO, ASE, dem_xyz_write), and dumps of LAMMPS and LIGGGHTS: the
     first frame. Pass the lines of another frame to dem_grains_parse.
   - legacy VTK, VTP and VTU (ParaView, LIGGGHTS, dem_vtp_write) as ASCII, base64 or raw bytes; a
     compressed file is an error.
   Names, in upper or lower case:
       position          x y z, or position, pos, points
       size              r or radius, d or diameter
       velocity          vx vy vz, or v, vel, velo, velocity
       angular velocity  wx wy wz, or omega, spin, angular_velocity
       material          material; otherwise type, if it is a number
   A component may follow a name, as in velocity:0, omegax, Position.X, and then a unit: (m), (mm),
   (cm), (um), (mm/s), (rad/s). `ignored` lists other columns, and the second of two that mean the
   same. Each sphere of a file of clusters becomes one grain. Error messages name file, line and
   reason. Free with dem_grains_free. */
DEM_API dem_result dem_grains_read(dem_world *world, const char *path, dem_grains *grains);
/* Reads grains from memory, `size` bytes at `data`, as dem_grains_read does. name: for error
   messages; or null. */
DEM_API dem_result dem_grains_parse(dem_world *world, const char *name, const void *data,
                                    size_t size, dem_grains *grains);
/* Frees grains that this world has read. */
DEM_API void dem_grains_free(dem_world *world, dem_grains *grains);
/* Adds all grains as spheres of one material or, if its id is 0, of the materials whose numbers the
   file gives. If one grain has a bad value, none is added. */
DEM_API dem_result dem_grains_add(dem_world *world, dem_material material,
                                  const dem_grains *grains);

/* The functions below, except the one for CSV, write to a temporary name and then rename the file,
   so that it is complete or absent. Links are followed; a pipe or a terminal is an error. In all
   files `id` is dem_body.slot less 1. */

/* Writes the bodies for ParaView (VTP): points with radius, velocity, spin, id, material and
   body_reals. If bodies have orientations, also the orientation (quaternion w x y z) and semi_axes
   (m); a cluster is then one point per sphere, all with its id. To draw them in ParaView: Glyph, a
   sphere of radius 1, scaled by semi_axes, rotated by orientation (quaternion). */
DEM_API dem_result dem_vtp_write(dem_world *world, const char *path);
/* Writes the same as a legacy VTK file, binary. */
DEM_API dem_result dem_vtk_write(dem_world *world, const char *path);
/* Writes the bodies for OVITO and ASE (extended XYZ): a chemical element that numbers the material
   (H: 1, He: 2), position, radius, velocity, body_reals and id. If bodies have orientations, also
   the orientation (x y z w) and semi-axes. The domain becomes the lattice. */
DEM_API dem_result dem_xyz_write(dem_world *world, const char *path);
/* Writes the contacts for ParaView (VTP), to show bonds, bridges and force chains: lines from
   centre to centre (with a wall: to the contact point), with force (N, on a), overlap (m), wall
   (id, 0: none) and the contact history under its names. Computes forces first if the scene has
   changed. */
DEM_API dem_result dem_contacts_vtp_write(dem_world *world, const char *path);
/* Writes the triangles of all meshes, profiles and surfaces of revolution in their present pose
   (VTP), with the id of the wall. Profiles are extruded from z0 to z1 (m, z0 < z1). */
DEM_API dem_result dem_walls_vtp_write(dem_world *world, const char *path, dem_real z0,
                                       dem_real z1);
/* Writes the surfaces of all bodies as polygons (VTP), with velocity (of each corner), id, material
   and body_reals. Polyhedra are drawn by their faces, round bodies by facets. */
DEM_API dem_result dem_surfaces_vtp_write(dem_world *world, const char *path);
/* Appends the loads of a wall to a CSV file: time (s), force (N), torque (N m), axial torque (N m),
   power (W), number of contacts. Writes the heading first if the file is new or empty. */
DEM_API dem_result dem_wall_loads_csv_write(dem_world *world, dem_wall wall, const char *path);

/* ---- replay: a run in one HTML file ---- */

/* A replay plays in any browser, without network or other files. It shows grains of every shape,
   coloured by speed, size, material or a number of your choice, walls as they move, plots of values
   against time, and the report. The mouse rotates the view.

       dem_replay_desc desc = DEM_REPLAY_DESC;
       desc.interval = 0.01;                           // s, from frame to frame
       dem_replay *replay = dem_replay_open(world, "pile.html", &desc);
       dem_world_run(world, 1, 0, 0);
       dem_replay_close(replay);

   A grain at rest takes 1.3 bytes per frame, a moving one at most 31; docs/replay.md gives measured
   sizes. The replay is written to a new file, path.XXXXXXXX.tmp, which dem_replay_close renames to
   `path`. A run that is killed leaves that file; renamed to a name in .html it plays up to its last
   complete frame. */
typedef struct dem_replay dem_replay;
/* Largest number of values that a replay plots. */
enum { DEM_REPLAY_VALUES = 16 };
/* How a replay is recorded. Begin with DEM_REPLAY_DESC. */
typedef struct dem_replay_desc {
    const char *title;          /* copied; null means the name of the file */
    /* Name of the numbers by which grains can be coloured: one in desc.body_reals, or one for the
       values of number_fn. Null means the first name, or "number". Copied, at most 63 characters.
       */
    const char *number;
    /* returns the number of a body, for every frame; null means one of desc.body_reals */
    double (*number_fn)(const dem_world *world, dem_body body, void *user);
    void *user;                 /* passed to number_fn; or null */
    /* m, >= 0, of positions; 0 means 1/32 of the smallest radius in the first frame */
    dem_real resolution;
    /* s, >= 0: a run writes frames automatically, the first when it begins and then at the steps
       nearest to multiples of the interval. A frame that cannot be written ends the replay, not the
       run: dem_replay_close returns the error. 0 means frames only from
       dem_replay_frame_write. */
    double interval;
} dem_replay_desc;
static const dem_replay_desc DEM_REPLAY_DESC_ZERO = DEM_ZERO;
#define DEM_REPLAY_DESC DEM_REPLAY_DESC_ZERO
/* Opens a replay of the world. desc: or null, for DEM_REPLAY_DESC. Close the replay before its
   world is destroyed. */
DEM_API dem_replay *dem_replay_open(dem_world *world, const char *path,
                                    const dem_replay_desc *desc);
/* Writes the present state as a frame. 30 to 300 frames make a good replay. */
DEM_API dem_result dem_replay_frame_write(dem_replay *replay);
/* Sets a value of the next frame, which the replay plots against time. name: 1 to 63 characters, at
   most 16 different names; it ends with the unit in brackets, and values with the same unit share a
   scale. A value that is not finite leaves a gap. */
DEM_API dem_result dem_replay_value_set(dem_replay *replay, const char *name, double value);
/* Adds the report, completes the file and frees the replay, also if it returns DEM_ERROR_FILE or
   DEM_ERROR_MEMORY. */
DEM_API dem_result dem_replay_close(dem_replay *replay);

/* ---- checkpoints ---- */

/* Writes a checkpoint: the whole state, with bodies, walls, contact history, neighbour list,
   ledger, fields, counters, and what each scheduled output has written. An error if a body is not
   at a finite position and velocity; then an existing file stays. */
DEM_API dem_result dem_checkpoint_write(dem_world *world, const char *path);
/* Reads a checkpoint and replaces the state of the world, which then continues bit for bit. The
   world must have been built like the one that wrote it, with the same desc, materials and walls.
   Functions and user pointers are not stored. Number of threads, allocator, allow_large_dt
   and user pointers may differ. Errors: a file that is cut short, damaged, or of another version or
   precision; a file of another scene, for which the message names the first field that differs,
   with both values. */
DEM_API dem_result dem_checkpoint_read(dem_world *world, const char *path);

/* ---- outputs on a schedule ---- */

/* A scheduled output. */
typedef struct dem_output { int32_t id; } dem_output;                        /* id counts from 1 */
/* Largest number of columns of a CSV file, the time not counted. */
enum { DEM_OUTPUT_COLUMNS = 32 };
/* The action of an output. */
typedef enum dem_output_kind {
    DEM_OUTPUT_CALL = 0,     /* calls a function */
    DEM_OUTPUT_VTP,          /* dem_vtp_write */
    DEM_OUTPUT_XYZ,          /* dem_xyz_write */
    DEM_OUTPUT_CONTACTS,     /* dem_contacts_vtp_write */
    DEM_OUTPUT_CHECKPOINT,   /* dem_checkpoint_write */
    DEM_OUTPUT_CSV,          /* appends the time and some values as a line to a CSV file */
    DEM_OUTPUT_SURFACES      /* dem_surfaces_vtp_write */
} dem_output_kind;
/* How an output works. Begin with DEM_OUTPUT_DESC. */
typedef struct dem_output_desc {
    dem_output_kind kind;
    /* Name of the file, copied. In "grains_####.vtp" the number of the output replaces ####; it is
       0 at `start`. Without # the file is replaced each time. The path of a CSV file has no #.
       DEM_OUTPUT_CALL: or null. */
    const char *path;
    double interval;         /* s, required, 1e-12 to 1e15 */
    double start, end;       /* s, times of the first and the last; end 0 means no last */
    /* CSV: what a line contains. One of three: the loads of this wall, as dem_wall_loads_csv_write;
       or the values that `values` writes, with `columns` as their names (1 to 32 words as in
       body_reals, copied); or, if all three are zero, steps, bodies, contacts, kinetic and
       rotational energy (J) and overlap_max */
    dem_wall wall;
    const char *columns;
    void (*values)(const dem_world *world, double *values, void *user);
    /* CALL: may change the world, but not step it. A return value other than 0 stops the run
       (DEM_ERROR_STOPPED). */
    int (*function)(dem_world *world, int64_t number, void *user);
    void *user;              /* passed to `values` and `function`; or null */
} dem_output_desc;
static const dem_output_desc DEM_OUTPUT_DESC_ZERO = DEM_ZERO;
#define DEM_OUTPUT_DESC DEM_OUTPUT_DESC_ZERO
/* Adds an output that a run writes automatically, at the steps nearest to start, start + interval
   and so on, in the order in which outputs were added. The first line of a CSV file replaces an
   older file of that name; a file with other columns is an error of the run. If a file cannot be
   written, the run stops with the state intact, and the next run tries that output again. Slabs
   have no outputs.
   After a restart: a checkpoint stores what each output has written. A world that reads it
   continues from there, with nothing missing and nothing twice, and removes later lines of a CSV
   file before it appends the next. Outputs are matched by kind and path, so add them before reading
   the checkpoint. Other outputs may be added, and times may differ.
   A function (DEM_OUTPUT_CALL) may add outputs, and write and read checkpoints; a checkpoint that
   it writes counts the present call as done. */
DEM_API dem_output dem_output_add(dem_world *world, const dem_output_desc *desc);
/* Adds an output by kind, path and interval (s) alone:
   dem_output_every_add(world, DEM_OUTPUT_VTP, "grains_####.vtp", 0.01). */
DEM_API dem_output dem_output_every_add(dem_world *world, dem_output_kind kind, const char *path,
                                        double interval);
/* Ends an output; files that it has written stay. Its id is never used again. To change an output,
   remove it and add another. The function of an output may remove any output, also its own. */
DEM_API dem_result dem_output_remove(dem_world *world, dem_output output);

/* ---- slabs: one scene on many processors ---- */

/* How slabs in different processes communicate; all zero for a single process. Processes form a
   ring in the order of their slabs (the last is below the first), and make the same calls in the
   same order. Both functions return 0, or another value to stop the run; slabs cannot be used after
   that. docs/parallel.md shows both for MPI. */
typedef struct dem_transport {
    /* Sends to the process below and to the one above, and receives from both. Sizes are in bytes,
       known on both ends, and may be 0. Both neighbours may be the same process: what it sends up
       then arrives from below. */
    int (*exchange_fn)(const void *to_lower, size_t to_lower_size,
                       void *from_lower, size_t from_lower_size,
                       const void *to_upper, size_t to_upper_size,
                       void *from_upper, size_t from_upper_size, void *user);
    /* Replaces each of `count` values by its sum (sum = 1) or maximum (sum = 0) over processes. */
    int (*reduce_fn)(double *values, int count, int sum, void *user);
    void *user;                /* passed to both; or null */
} dem_transport;

/* How a scene is divided. Begin with DEM_SLABS_DESC. */
typedef struct dem_slabs_desc {
    int axis;                  /* 0, 1, 2: borders are planes x, y, z = const */
    /* required, 1 to 1024: number of slabs in all processes; only runs with the same number have
       the same bits */
    int count;
    /* this process holds the slabs first to first + local - 1; local 0 means all */
    int first, local;
    dem_transport transport;   /* required if another process holds slabs */
    /* borders move if the work of the busiest slab exceeds this many times the mean, >= 1; 0 means
       1.1. Below 0 borders do not move. */
    dem_real balance;
    int balance_interval;      /* rebuilds between two checks of the balance; 0 means 8 */
} dem_slabs_desc;
static const dem_slabs_desc DEM_SLABS_DESC_ZERO = DEM_ZERO;
#define DEM_SLABS_DESC DEM_SLABS_DESC_ZERO

/* The slabs that one process holds. */
typedef struct dem_slabs dem_slabs;

/* Creates slabs from a world: copies its grains to them, with everything a step needs. The world
   stays as it is, and may be destroyed. Every process builds the same world and passes its own
   `first` and `local`. Feeds and outlets continue in the slabs. An error with DEM_RESPONSE_IMPULSES
   and if processes have built different scenes; dem_world_error_get(world) returns the message. */
DEM_API dem_slabs *dem_slabs_create(dem_world *world, const dem_slabs_desc *desc);
/* Destroys slabs and frees their memory. */
DEM_API void dem_slabs_destroy(dem_slabs *slabs);
/* Advances all slabs by `steps` time steps (>= 0). Errors as for dem_world_step; DEM_ERROR_STOPPED
   also if the transport has failed. */
DEM_API dem_result dem_slabs_step(dem_slabs *slabs, int steps);
/* Copies the state of all slabs into a world of the same scene, in every process: grains, contact
   history, walls, loads, fields, feeds, outlets, ledger, time. The world can then be measured,
   written, stepped, or divided into slabs again, without effect on these slabs. It has no neighbour
   list until dem_candidates_rebuild; after that it continues as the slabs would. */
DEM_API dem_result dem_slabs_collect(dem_slabs *slabs, dem_world *world);
/* Sets the time integrals of wall loads and the largest overlap to 0, in this process's slabs. */
DEM_API void dem_slabs_loads_reset(dem_slabs *slabs);
/* Returns the error message of the last failed call on these slabs, or "". */
DEM_API const char *dem_slabs_error_get(const dem_slabs *slabs);

/* One slab. */
typedef struct dem_slab {
    int grains, ghosts;        /* its own grains; copies of grains of the lower neighbour */
    double lo, hi;             /* m, its borders; -1e300, 1e300: none on that side */
    double work;               /* candidates + 4 per body, at the last rebuild */
    double seconds;            /* wall time spent on it so far */
    uint64_t bytes;            /* sent to its neighbours so far, as if in other processes */
} dem_slab;
/* Describes one slab of this process; index: first to first + local - 1. */
DEM_API dem_result dem_slab_get(const dem_slabs *slabs, int index, dem_slab *slab);
/* Counters of slabs. */
typedef struct dem_slabs_counters {
    double time;               /* s, simulated */
    uint64_t steps, rebuilds, border_moves;
    uint64_t migrated;         /* grains that changed slabs, in this process */
    dem_real skin, dt;         /* m, s, in use */
} dem_slabs_counters;
/* Returns the counters of slabs. */
DEM_API dem_slabs_counters dem_slabs_counters_get(const dem_slabs *slabs);

/* ---- effects: what a scene contains, what has happened, and what each effect costs ---- */

/* The state of an effect. */
typedef enum dem_effect_state {
    DEM_EFFECT_OFF,                /* the scene does not contain it; it costs nothing */
    DEM_EFFECT_IDLE,               /* the scene contains it, but it has not happened so far */
    DEM_EFFECT_ACTIVE
} dem_effect_state;
/* An effect of the scene, such as friction, walls or the ledger. */
typedef struct dem_effect {
    const char *name;
    dem_effect_state state;
    /* fraction of the time of a step that is saved without the effect; its standard error */
    double share, error;
    int measured;                  /* 1: share was measured; 0: no budget, or it cannot be */
    /* number of pairs of materials, walls and the like that have the effect and that nothing has
       touched; 0: everything in the scene has happened */
    int missing;
    char text[200];                /* what acts; why nothing acts; what has not happened */
} dem_effect;
/* Number of effects. */
enum { DEM_EFFECTS = 16 };
/* Writes for every effect whether it is off, idle or active, and returns their number. It finds a
   material with rolling friction on which nothing has rolled, or a wall that nothing has touched.
   It can miss contacts of spheres that begin and end between two neighbour lists. If `budget` (s of
   wall time, >= 0) is not 0, it also measures what each effect costs: two copies of the world, one
   without the effect, take steps in turn. User-defined laws (by pointer) and fields are called
   twice instead of being left out, and friction is left out together with rolling friction. Shares
   need not add up to 1; on a busy machine they are noise. User-defined functions are called for the
   copies, too. The world does not change. Returns -1 also if the scene would not run. */
DEM_API int dem_effects_get(dem_world *world, double budget, dem_effect effects[DEM_EFFECTS]);
/* Prints the effects as lines of text. A share outside -0.1 to 1, or with an error above 0.1, is
   printed as "too noisy". */
DEM_API void dem_effects_print(dem_world *world, double budget, FILE *out);

/* ---- report ---- */

/* Prints the report: bodies, time step and what limits it, contact detection, laws and effects,
   what the scene contains but has not happened, the largest overlap, pairs of materials, loads of
   walls, joints, feeds, outlets, and the ledger. It calls a user-defined force field once per
   body. */
DEM_API void dem_world_report(const dem_world *world, FILE *out);

/* Creates a world if `version` and `real_size` (bytes of dem_real) are those of the implementation,
   and returns null otherwise. Call dem_world_create, which passes both. */
DEM_API dem_world *dem_world_create_checked(const dem_world_desc *desc, int version,
                                            size_t real_size);
/* Creates an empty world; see >>scene. */
static inline dem_world *dem_world_create(const dem_world_desc *desc) {
    return dem_world_create_checked(desc, DEM_VERSION, sizeof(dem_real));
}

#ifdef __cplusplus
}
#endif
