/* ---------------------------------------------------------------------------------------------
   >>run
   What a program does with a scene: check it, run it, compare choices, measure it.
   --------------------------------------------------------------------------------------------- */

/* Errors in this part. Functions fail as in >>scene and return the codes of dem_result; comments
   below state only further reasons. A function that returns a count returns -1 if it fails, unless
   its comment says otherwise. Other functions that return a number or a struct return zeros for a
   null world. An argument or field may be null only where "or null" is written. */

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

#ifndef DEM_NO_REPORTS
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
#endif /* DEM_NO_REPORTS */

/* ---- run ---- */

/* Advances the world by `steps` time steps (>= 0), or to the first step that fails. The error
   message names that step; the steps before it are kept. The first step is not taken while the
   error message of a call that builds the scene is unread (dem_world_error_get). Errors:
       DEM_ERROR_ARGUMENT   an unread message (above), or a scene that cannot run, such as a period
                            that is too short, or rolling friction with a solver that ignores it
       DEM_ERROR_TIME_STEP  the step is too large for the contacts, or a body or wall would move by
                            more than the smallest radius (a body under impulses: by more than this
                            and more than half the range below which contacts are solved), a body
                            that is not a sphere rotate by more than 1 rad, a cell strain by more
                            than 0.01
       DEM_ERROR_UNSTABLE   a position, velocity, force or number of a body is not finite, two
                            bodies overlap by the smaller radius, a body and a wall by that of the
                            body, or a motion or desc.growth returns impossible values
       DEM_ERROR_FILE, DEM_ERROR_FORMAT    an output cannot be written; its CSV has other columns.
                            The next call writes it, also one of 0 steps.
       DEM_ERROR_STOPPED    an output stopped the run; desc.unsolved_stops is 1 and the sweeps of a
                            step did not reach the tolerance; or an overlap is above
                            desc.overlap_stop. The step is complete.
       DEM_ERROR_MEMORY     The bodies and the time may have moved already. The step counts
                            (dem_world_steps_get) when it is complete: the next call completes it as
                            its first step, here or in a world that has read a checkpoint written
                            meanwhile. The bits are those of a run without the interruption. */
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
   that spins on a point. Checks are sqrt(R/g) apart, the time of a fall by half the mean radius R
   (without gravity: the time in which `speed` covers R/2, at most seconds/4). All feeds, also those
   that begin later, must have inserted all their grains first.
   speed: m/s, >= 0; 0: 0.01 sqrt(2 g R), which needs gravity. progress: or null.
   Errors as for dem_world_step; also DEM_ERROR_ARGUMENT for a feed with neither `limited` nor
   `end`, and DEM_ERROR_STOPPED if the time is up: the message gives the speeds, the feed that is
   not done, or the time that three checks take; the state is intact. */
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

/* How the sides of a periodic domain, the cell, move. Begin with DEM_CELL_DESC: they do not. */
typedef struct dem_cell_desc {
    dem_vec3 rate;            /* 1/s, strain rate of each axis; positive: the cell becomes longer */
    dem_real shear;           /* 1/s, shear rate: change of the velocity along x with y */
    dem_vec3 stress;          /* Pa, pressure positive: target of axes that have a rate_most */
    /* 1/s, >= 0: largest strain rate by which the cell is led to `stress` along this axis, whose
       `rate` must be 0; 0: the axis follows `rate` */
    dem_vec3 rate_most;
} dem_cell_desc;
static const dem_cell_desc DEM_CELL_DESC_ZERO = DEM_ZERO;
#define DEM_CELL_DESC DEM_CELL_DESC_ZERO
/* Deforms the cell from now on, for tests of materials without walls. The centre of the domain
   stays in place. All positions, those of fixed bodies too, follow the strain affinely: the flow of
   the cell is rate (x - centre), plus shear (y - centre) along x. Velocities of bodies are relative
   to this flow, here and in user-defined functions, and their kinetic energy is that of these
   velocities. Contacts see the difference of the flow between both bodies, so no place of the cell
   differs from another [EVA08], and images across the y faces move with the shear [LEE72]. Along
   axes with a rate_most the rate is chosen before each step; its gain follows from the contacts
   (>>stress). Further calls may change everything at any time; contact histories stay. Axes that
   move must be periodic; a shear needs x and y. The ledger counts the work of the cell as `cell`.
   Checkpoints store the cell. An error with DEM_RESPONSE_IMPULSES, in slabs, and together with
   walls, joints, rails, feeds and outlets. Fields, fills and selections by region are an error
   while a cell is sheared. A step that would strain the cell by more than 0.01 fails with
   DEM_ERROR_TIME_STEP. */
DEM_API dem_result dem_cell_set(dem_world *world, const dem_cell_desc *desc);
/* What the cell does. */
typedef struct dem_cell_state {
    dem_box box;              /* m, the domain now */
    dem_real offset;          /* m, along x: displacement of images across the upper y face */
    /* since the beginning: logarithmic strain of each axis, > 0: longer; shear strain */
    double strain[3], shear;
    double rate[3], shear_rate;    /* 1/s, of the last step */
    double stress[3];         /* Pa, along each axis, before the last step; at first 0 */
} dem_cell_state;
/* Writes the state of the cell to state. */
DEM_API dem_result dem_cell_state_get(const dem_world *world, dem_cell_state *state);

/* Sets the time step, s (1e-20 to 1e15), from now on. 0: chosen from the scene, as with desc.dt; an
   error with DEM_RESPONSE_IMPULSES. Contact history stays. Checkpoints store the step. If it is too
   large, the next dem_world_step returns DEM_ERROR_TIME_STEP. */
DEM_API dem_result dem_world_dt_set(dem_world *world, dem_real dt);

/* Returns the simulated time, s. */
DEM_API double dem_world_time_get(const dem_world *world);
/* Returns the number of complete steps. */
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
    /* impulses: solves whose sweeps did not reach the tolerance. dem.h solves once per step, and
       once more after the scene has changed, for instance when a feed has added a grain */
    uint64_t unsolved;
    size_t memory;              /* bytes allocated by the world */
} dem_counters;
/* Returns the counters. */
DEM_API dem_counters dem_counters_get(const dem_world *world);
/* Sets the counter overlap_max to 0, for instance after a scene has been built. */
DEM_API void dem_overlap_max_reset(dem_world *world);

/* The account of energy, J, since the world was created; zeros unless desc.ledger is 1.
       residual = kinetic + rotational + elastic - gravity - walls - force - cell - inserted
                  - growth + removed + normal + slide + tangent + rolling
   The residual is the error of the time integration; compare it with `throughput`. Potential energy
   is not stored energy here: `gravity` is the work of gravity. If a user-defined law never fills
   force->energy, the ledger cannot separate what the law stores from what it dissipates: `unknown`
   then holds the residual, and `residual` is 0. */
typedef struct dem_ledger {
    double kinetic, rotational, elastic;    /* stored now */
    /* supplied: work of gravity; of moving walls, belts, motors and rails; of force fields; of a
       cell that deforms; kinetic energy of inserted bodies, and its changes by dem_body_set and
       other calls that set velocities, fix bodies or change masses */
    double gravity, walls, force, cell, inserted;
    /* dissipated: by normal dashpots, hysteresis, impacts and joints; by sliding; by tangential
       dashpots; by rolling resistance */
    double normal, slide, tangent, rolling;
    double removed;                         /* kinetic energy of removed bodies */
    double throughput;                      /* sum of the magnitudes of what was supplied */
    /* supplied: what springs gain when the scene changes and nothing moves: radii grow, bodies or
       walls are added, moved or removed between steps, materials change. In the residual are: what
       springs hold on a grain that an outlet or outflow boundary removes, what they gain when two
       walls in one place part below a grain, what a contact holds as it leaves its law's range. */
    double growth;
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

#ifndef DEM_NO_TRIALS
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
#endif /* DEM_NO_TRIALS */

/* ---- contacts ---- */

/* One contact. */
typedef struct dem_contact_info {
    dem_body a, b;                       /* b is null for a contact with a wall */
    int32_t wall;                        /* dem_wall id; 0: b is a body */
    dem_vec3 point, normal;              /* m, on the surface of a wall; unit, from a to b */
    dem_real overlap;                    /* m; < 0: a gap within the range of the law */
    dem_vec3 force;                      /* N, on a */
    int further;                         /* 1: another point of the polyhedron's contact before */
} dem_contact_info;
/* Writes the contacts, those with walls included, at most `capacity` of them, and returns their
   number. `out` or null. The contact history does not change. A contact of two polyhedra, or of one
   with a wall, is written as up to four (dem_shape_polyhedron_add). Contacts of two spheres are
   those of the present state; all others, and with impulses all, are as the last computation of
   forces has left them. With impulses these forces, gravity and force fields together give the
   change of the velocities in the coming step. After bodies, walls or materials have changed, call
   dem_contacts_each first: it computes them. Returns -1 if they are not known: before the first
   step, and after bodies or walls have changed. */
DEM_API int dem_contacts_get(const dem_world *world, dem_contact_info *out, int capacity);
/* Receives one contact and its history. memory: as many reals as desc.law_memory, and one more if a
   pair has static friction, which is 1 while the contact slides (built-in laws: 0 to 10 in all;
   impulses: 17); vectors as seen from a. Values that the function writes there count from the
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
/* Rebuilds the neighbour list, not the contacts, for tests and analysis. A run does so too. */
DEM_API dem_result dem_candidates_rebuild(dem_world *world);

/* ---- contact events: collisions, impact energies, wear ---- */

/* What a function of events is called for. */
typedef enum dem_event_kind {
    DEM_EVENT_END = 0,             /* a contact has ended */
    DEM_EVENT_BEGIN,               /* a contact has begun */
    DEM_EVENT_OPEN                 /* a contact exists: dem_events_open_each */
} dem_event_kind;
/* A contact of two bodies, or of a body and a wall, from its beginning to its end. It exists while
   any of their contact points has an overlap, or while a law with a range exerts a force beyond
   contact; with impulses, while its impulse is not 0. Bodies of several spheres and walls of
   several facets have one contact with each other. */
typedef struct dem_event {
    dem_event_kind kind;
    dem_body a, b;                 /* a has the lower slot; b is null for a contact with a wall */
    int32_t wall;                  /* dem_wall id; 0: b is a body */
    dem_material material_a, material_b;
    /* 1: recording began during the contact; 2: it ended because a body or the wall was removed; 3:
       both. Else 0. */
    int cut;
    dem_vec3 point, normal;        /* m; unit, from a to b: where it began */
    double begin, end;             /* s; end: the present time unless kind is DEM_EVENT_END */
    /* m/s, relative velocity at the contact point when it began: along the normal, > 0 if the two
       approach; across it. They belong to the first step of the contact. */
    double closing_speed, slip_speed;
    /* kg, effective mass m_a m_b/(m_a + m_b) for a central impact; fixed bodies and walls are
       infinitely heavy; 0: neither can move */
    double mass;
    /* N, the largest normal force, summed over contact points (of impulses the mean over a step);
       N s, the normal force summed over time */
    double force, impulse;
    /* J, energy lost so far as in dem_ledger: by the normal law, by sliding, by tangential dashpots
       (and springs that held energy at the end; what they stored when recording began counts as
       supplied), by rolling resistance */
    double lost_normal, lost_slide, lost_tangent, lost_rolling;
} dem_event;
/* Receives one contact. It may only read the world. */
typedef void (*dem_event_fn)(const dem_event *event, void *user);
/* How contacts are recorded. Begin with DEM_EVENTS_DESC. */
typedef struct dem_events_desc {
    /* called after each step for the contacts that have ended in it; null means no call. The
       contacts are in the order of their ids, for any number of threads and slabs. */
    dem_event_fn function;
    void *user;                    /* passed to `function`; or null */
    int begins;                    /* 1: also called for contacts that have begun, before those */
} dem_events_desc;
static const dem_events_desc DEM_EVENTS_DESC_ZERO = DEM_ZERO;
#define DEM_EVENTS_DESC DEM_EVENTS_DESC_ZERO
/* Starts to record contacts; needs desc.ledger. If they are recorded already, replaces the function
   and keeps the records. Forces and motions have the same bits as without a recording. Checkpoints
   contain the records, but not the function: call this again after reading one in a new program.
   Slabs continue the recording of the world from which they are created, if one process holds them
   all; dem_slabs_collect returns it. A step that has no memory for the records completes, stops the
   recording and fails with DEM_ERROR_MEMORY. */
DEM_API dem_result dem_events_record(dem_world *world, const dem_events_desc *desc);
/* Ends the recording and discards its records. */
DEM_API dem_result dem_events_stop(dem_world *world);
/* Calls `fn` for every contact that exists, in the order of ids, and returns their number. fn and
   user: or null. Returns -1 if contacts are not recorded. */
DEM_API int dem_events_open_each(dem_world *world, dem_event_fn fn, void *user);

/* Number of bins of impact energies: five per decade from 1e-18 J to 1e6 J. The first and the last
   bin also count what is outside. */
enum { DEM_IMPACT_BINS = 120, DEM_IMPACT_LIMITS = 121 };
/* Statistics of the recorded contacts. */
typedef struct dem_impacts {
    double seconds;                /* s, recorded so far */
    double ended;                  /* number of contacts that have ended */
    int open;                      /* number of contacts that exist */
    double rate;                   /* 1/s: ended/seconds */
    /* J, lost in all recorded contacts, those that exist included. For all materials these are what
       the ledger has booked since recording began, except losses of joints. */
    double lost_normal, lost_slide, lost_tangent, lost_rolling;
    double bin[DEM_IMPACT_LIMITS];             /* J, limits of the bins */
    /* contacts that have ended, by energy of impact mass*closing_speed^2/2; those that had begun
       before the recording are not counted */
    double impacts[DEM_IMPACT_BINS];
    /* contacts that have ended, by energy lost in them (the sum of all four losses); and the energy
       lost in the contacts of each bin, J */
    double losses[DEM_IMPACT_BINS], energy[DEM_IMPACT_BINS];
} dem_impacts;
/* Computes the statistics of contacts between two materials, walls included; material id 0 means
   any. An error if contacts are not recorded. */
DEM_API dem_result dem_impacts_get(dem_world *world, dem_material a, dem_material b,
                                   dem_impacts *impacts);
#ifndef DEM_NO_FILES
/* Writes the spectra of all pairs of materials that have touched to a CSV file. A line per bin that
   is not empty: material_a, material_b, from, to (J), impacts, losses (both 1/s), power (W). */
DEM_API dem_result dem_impacts_csv_write(dem_world *world, const char *path);
#endif /* DEM_NO_FILES */

/* Wear of a wall since recording began. */
typedef struct dem_wear {
    double seconds;                /* s, recorded so far */
    double slide, normal;          /* J, lost on it by sliding; by the normal law */
    double volume;                 /* m3, coefficient*slide/hardness */
} dem_wear;
/* Computes the wear of a wall by Archard's law: the worn volume is the work of sliding times a
   dimensionless coefficient, over the hardness (Pa, > 0) of the softer side. coefficient: >= 0,
   that of Archard (per normal force and distance) divided by the coefficient of friction. */
DEM_API dem_result dem_wall_wear_get(dem_world *world, dem_wall wall, double coefficient,
                                     double hardness, dem_wear *wear);
/* Writes the work of sliding on each facet (mesh) or segment (profile) of a wall, J, in the order
   of its elements, at most `capacity` of them, and returns their number (0: the wall has no
   facets). The work counts for the facet that is nearest to the contact point. work: or null.
   Returns -1 if contacts are not recorded. */
DEM_API int dem_wall_wear_facets_get(dem_world *world, dem_wall wall, double *work, int capacity);

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

/* Stress and fabric of the whole domain. Tensors are xx yy zz xy xz yz. */
typedef struct dem_stress {
    double volume, solid;     /* m3, of the domain; fraction that bodies fill */
    /* Pa, pressure positive: of contacts, the sum of force x branch over the volume; of motion, the
       sum of m v v over the volume, about the mean velocity; both together. The branch of a contact
       with a wall ends on the surface of the wall. At rest without weight, stress x volume is
       therefore the sum of force x position over the contact points on all walls: between two
       planes their force x distance, at curved walls that sum over the curved surface. */
    double contact[6], kinetic[6], total[6];
    double fabric[6];         /* mean of n n over the contacts of two bodies; its trace is 1 */
    int contacts;             /* of two bodies */
    double coordination;      /* contacts per body, with walls */
} dem_stress;
/* Computes stress and fabric of the present state in one pass over bodies and contacts. The domain
   must have an extent along all axes (planar: along x and y; its depth is desc.thickness). An error
   if bodies or walls have changed since the last step; then call dem_contacts_each first (see
   dem_contacts_get). */
DEM_API dem_result dem_stress_get(const dem_world *world, dem_stress *stress);

/* A field: a grid of cells on which a run averages solid fraction, velocity and, if desired, stress
   over a window of time. A grain counts in the cell of its centre ([MIL] 5.2.9), so cells smaller
   than grains need a long window; or it is spread about its centre by coarse graining (width).
   Begin with DEM_FIELD_DESC. */
typedef struct dem_field_desc {
    /* m, required: what the cells divide. In planar worlds cells are desc.thickness deep, whatever
       the extent of the box along z, which must contain 0. */
    dem_box box;
    int cells[3];             /* required, >= 1: along each axis, at most 2^28 in all */
    double start, end;        /* s, window of time; end 0 means no end */
    double interval;          /* s, from start on; 0 means every 100 steps of the present dt */
    dem_material material;    /* only grains of this material; id 0 means all grains */
    dem_real radius_min, radius_max;  /* m, only of these (bounding) radii; max 0 means any */
    int stress;               /* 1: also flux, stress and contacts; visits every contact */
    /* m, of coarse graining; 0 means none. Each grain is then spread by Lucy's function of reach
       c = 2 width [GOL10], 105/(16 pi c^3) (1 + 3 r/c) (1 - r/c)^3 (planar: 5/(pi c^2) in place of
       the first factor), evaluated at the centres of cells. Keep cells no longer than width. */
    dem_real width;
    dem_group group;          /* only members of this group; id 0 means all grains */
    int variance;             /* 1: also variances of cells over the samples; not in slabs */
    int bodies;               /* 1: also averages each grain (dem_body_means); one field may */
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
       grain accounts for its half; one with a wall acts from the centre to the wall's surface.
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
    /* Variances over the samples, of the values of the whole cell; 0 unless desc.variance is 1:
       of grains, solid, density, (kg/m3)^2, and velocity, m2/s2, weighted by mass. The mean of n
       independent samples has the standard error sqrt(variance/n). */
    double grains_variance, solid_variance, density_variance, velocity_variance[3];
} dem_field_cell;
/* Averages of one grain over the samples of the field with desc.bodies, wherever the grain was. The
   field chooses grains by material, radius and group. */
typedef struct dem_body_means {
    uint64_t samples;         /* number of samples; 0: all others are 0 */
    double velocity[3], velocity_variance[3];   /* m/s; m2/s2 */
    double spin[3], spin_variance[3];           /* rad/s; (rad/s)^2 */
    double force[3], force_variance[3];         /* N; N2: of contacts and fields, not of gravity */
} dem_body_means;
/* Writes pointers to the sums of a field to `data`. */
DEM_API dem_result dem_field_get(const dem_world *world, dem_field field, dem_field_data *data);
/* Computes the means of the cell (i, j, k), which count from 0. */
DEM_API dem_result dem_field_cell_get(const dem_world *world, dem_field field, int i, int j, int k,
                                      dem_field_cell *cell);
/* Writes the averages of a grain to means. An error if no field averages bodies. */
DEM_API dem_result dem_body_means_get(const dem_world *world, dem_body body,
                                      dem_body_means *means);
/* Sets the sums of a field, the averages of its bodies and its number of samples to 0; the window
   of time stays. */
DEM_API dem_result dem_field_reset(dem_world *world, dem_field field);

/* Two components of a mixture: the grains of one material or of a range of radii, and all others.
   Only grains in `box` that can move count. Begin with DEM_MIXING_DESC. */
typedef struct dem_mixing_desc {
    dem_box box;              /* m, required: what the cells divide */
    int cells[3];             /* required, >= 1: along each axis; 10 to 30 grains per cell suit */
    /* the component: a material (id 0: any), and (bounding) radii, m (max 0: any); not both open */
    dem_material material;
    dem_real radius_min, radius_max;
    dem_vec3 centre, axis;    /* m, a point on an axis; its direction, of any length, 0: no axis */
} dem_mixing_desc;
static const dem_mixing_desc DEM_MIXING_DESC_ZERO = DEM_ZERO;
#define DEM_MIXING_DESC DEM_MIXING_DESC_ZERO
/* Mixing of two components (>>mixing has the formulas). Indices that are not defined are NaN: if
   one component is absent, if all grains are in one cell, or if no cell has two grains. */
typedef struct dem_mixing {
    int grains, part;         /* grains in the box; of these, grains of the component */
    int cells;                /* cells with at least one grain */
    double fraction;          /* part/grains */
    /* variance of the component's fraction over the cells, weighted by their grains; of cells that
       hold one component each; of a random mixture */
    double variance, variance_segregated, variance_random;
    /* [LAC54]: 0 segregated, 1 random, above 1 more regular than random; Kramer's index, the same
       with standard deviations instead of variances */
    double lacey, kramer;
    /* along x, y, z, and of the distance from the axis: 1 if the component is ahead of all others,
       0 random, -1 if it is behind; random mixtures deviate by sqrt((N + 1)/(3 Na Nb)) */
    double segregation[3], segregation_radial;
    int contacts;             /* between grains in the box; -1: no list (dem_contacts_get) */
    double contact_segregation;   /* 1: no contact between the components, 0 random; needs a list */
} dem_mixing;
/* Computes the mixing of two components from the present places of all grains. */
DEM_API dem_result dem_mixing_get(const dem_world *world, const dem_mixing_desc *desc,
                                  dem_mixing *mixing);

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
