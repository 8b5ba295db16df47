/* ---------------------------------------------------------------------------------------------
   >>state
   The state of a world: its numbers, by the part that owns them, its bodies, and the world itself,
   which owns everything else. Every array that grows is a field here. DEMI_GROW enlarges it and
   keeps its contents, or leaves it unchanged and reports that memory ran out.
   --------------------------------------------------------------------------------------------- */
/* --- the numbers of a world, by the part that owns them. These structs are saved and copied whole,
       so a new field is saved too. Pointers and derived data do not belong here. --- */

/* Why an automatic time step is shorter than t_c/50, for the report. */
enum { DEMI_HELD_NOT, DEMI_HELD_DASHPOT, DEMI_HELD_SPIN, DEMI_HELD_PRESSED, DEMI_HELD_RATE };
typedef struct demi_held {
    double from, limit, contacts;  /* t_c/50, s; the limit, s (of a spin: rad/s); number of contacts
                                      that press the body */
    int32_t by, body;              /* DEMI_HELD_...; the body's id, 0: unknown */
} demi_held;
typedef struct demi_timing {       /* >>step, >>advice */
    double time;                   /* s: since.time + (steps - since.steps) since.dt */
    demi_since since;              /* when the present dt came into force */
    uint64_t steps, rebuilds;
    uint64_t last_rebuild;         /* step */
    double run_end;                /* s: requested end of the last run, */
    uint64_t run_steps;            /* and the step at which it ended */
    dem_real dt;                   /* s */
    double half_kick;              /* s, half kick of the present step */
    double assumed_speed;          /* m/s, impact speed that dt was chosen for */
    double grown;                  /* s: end of the step for which radii were set (>>growth) */
    uint64_t press_due;            /* step of the next search for pressed bodies (>>advice) */
    uint64_t press_since;          /* step of the last change of the scene */
    demi_held held;
} demi_timing;
enum { DEMI_LIST_ALONE = 2 };
/* Which of the data that a step needs are valid. A change of the scene clears dt_valid,
   forces_valid and primed; adding or removing bodies also clears list_valid. dem_world_step
   restores what is missing, in the order 1 to 4: */
typedef struct demi_stages {
    int dt_valid;                  /* 1: the time step suits the scene */
    int list_valid;                /* 2: the candidate lists fit the bodies; DEMI_LIST_ALONE:
                                      their contacts have not been computed */
    int pairs_changed;             /* properties of a pair of materials have changed since */
    int forces_valid;              /* 3: forces belong to the present positions and velocities */
    int primed;                    /* 4: half-step velocities belong to the previous half step */
    int moved;                     /* bodies have moved in a step whose forces are missing, because
                                      memory ran out */
    int synced;                    /* no half kick is pending: see demi_finish */
    int near_stale;                /* the pruned list lacks a pair of a body that was inserted */
    int quiet;                     /* isolated bodies are known (>>near): the scene has not changed
                                      since the pruned list was made */
    /* 1: a rebuild that ran out of memory had chosen the skin, or the span of the pruned list. The
       next try keeps them, because the counts behind the choice may be lost */
    int skin_chosen, near_chosen;
} demi_stages;
/* Wall candidates of a body: first .. end - 1, end 0 if there are none. gap: m, to the nearest
   sheet among them, or DEMI_ONLY_SHEET; negative if it is not known. */
typedef struct demi_walled { int32_t first, end; dem_real gap; } demi_walled;
typedef struct demi_margin {       /* >>rebuild, >>near: how long lists are valid */
    double skin, gone, walls_gone; /* m: skin; largest displacement of a body and of a wall point
                                      since the rebuild */
    double step_gone;              /* m, largest displacement of any point of a body in a step */
    double skin_auto;              /* m: skin proposed by the cost model; 0: none yet */
    double span, age;              /* s: intended lifetime of the pruned list; its age */
    double slack;                  /* m: allowance in the pruned list for changes of velocity */
    double change, last_change;    /* m/s: bound on the change of a velocity since the list was
                                      built; in the last step */
    double creep;                  /* m: bound on the approach of two bodies by these changes */
    double reach;                  /* m: largest gap at which a law is called; 0: only in contact */
    double pace, walls_pace;       /* m/s: fastest point of a body; with impulses, fastest point of
                                      a wall, 1e300: there is no bound */
    double seen, cover;            /* m, at most `reach`: with impulses, gap below which this step
                                      finds contacts; that for which the pruned list is made */
} demi_margin;
typedef struct demi_in_force {     /* >>rebuild: determined at each rebuild */
    int tangent, rolling;          /* laws in force */
    int twisting;                  /* a pair has spinning friction, and no user-defined law */
    int uniform;                   /* one radius, one mass, one material, no fixed body */
    int fixed_count;
    int unlike;                    /* number of bodies that pairs do not see as lone spheres */
    int tight;                     /* some body is so long that candidates are tested by more than
                                      bounding spheres */
    int ignoring;                  /* 1: some pair of materials is ignored (dem_pair) */
    int sticks;                    /* a pair has static friction above its sliding friction */
    int clustered;                 /* springs, and the scene has a cluster of spheres: pairs of the
                                      pruned list are pairs of their member spheres (>>members) */
    int species_count;             /* DEMI_SPECIES + 1: more than that */
    demi_species species[DEMI_SPECIES];
    dem_real radius_min, radius_max;           /* m */
    uint64_t scales;               /* bit k: tessellations for bodies of scale k exist */
} demi_in_force;
typedef struct demi_levels {       /* >>search */
    int count, wide;               /* levels in use, 0: one grid; radii differ so much that levels
                                      are cheaper */
    demi_level level[DEMI_LEVELS]; /* the coarsest first */
    double fine;                   /* m, largest radius of the finest class */
    double tests[2];               /* estimated distance tests per body: one grid, levels */
} demi_levels;
/* Overlaps above DEMI_OVERLAP_LIMIT since the last reset (demi_crushed_note). */
typedef struct demi_crushed {
    double next;                   /* relative to the radius: overlap that is noted next; 0: none
                                      has been */
    double since, time;            /* s, of the first and of the last note */
    int32_t a, b, wall, none;      /* of the last: slots of the bodies + 1 (b 0: a wall), id of the
                                      wall; padding, 0 */
} demi_crushed;
typedef struct demi_booked {       /* >>ledger: totals and maxima since the beginning */
    double energy[DEMI_ENERGIES], inserted, removed, throughput;       /* J */
    double overlap_max, speed_max; /* relative to the radius; m/s */
    demi_crushed crushed;
    uint64_t met[DEMI_MATERIALS];  /* bit j of i, i <= j: materials i and j have touched */
    double due[5];                 /* J: energies that impulses, walls and force fields will take
                                      or give in the next step, see demi_impulses_tell */
    double residual, residual_rms; /* m/s, of the last solve: largest, rms */
    uint64_t unsolved;             /* solves that did not reach their tolerance */
    int sweeps, none;              /* of the last solve; padding, 0 */
} demi_booked;

/* A periodic cell that deforms. rate: of the last step; `stress` is that at which it was chosen. */
typedef struct demi_strained {       /* >>cell, >>stress */
    dem_cell_desc desc;
    double mid[3], side[3];        /* m: its centre, which does not move, and its sides */
    double offset;                 /* m, along x, of the image across the upper y face */
    double rate[3], shear;         /* 1/s */
    double strain[3], sheared;     /* logarithmic strains, and shear strain, since the beginning */
    double stress[3], stiffness[3], damping[3];        /* Pa; Pa; Pa s */
    double squeeze;                /* m, bound on the approach of a candidate pair in a step */
    int on, none;                  /* 1: it moves, or is sheared; padding, 0 */
} demi_strained;

/* Bodies. A slot identifies a body and never changes; its index in the arrays changes with every
   rebuild. Part >>bodies owns them, integrators move them, contacts add forces. demi_body_arrays
   says how each array is used. "x 4": four reals per body. */
typedef struct demi_bodies {
    int count, capacity;           /* bodies */
    dem_real *pos, *vel, *spin;    /* x 4; at the full step (predicted within a step). pos: x, y, z,
                                      radius */
    dem_real *half_vel, *half_spin;/* x 4; mean over the last step, i.e. at its half step */
    dem_real *last_pos;            /* x 4; one step ago (position Verlet). Impulses: these two are
                                      positions and orientations of the full step while contacts
                                      are found at the half step */
    dem_real *last_orient;
    uint8_t *went;                 /* impulses: 1: the body has made a step since it was added or
                                      set */
    dem_real *force, *torque;      /* x 4 */
    dem_real *inv_mass, *inv_inertia, *mass;     /* inv_inertia: only of moving spheres, else 0 */
    int backward;                  /* last_pos exists */
    int booked;                    /* `late` exists: a ledger, and a scheme that predicts */
    dem_real *late;                /* x 4; m/s: error of the last prediction of the velocity */
    int orienting;                 /* the next four exist */
    dem_real *orient;              /* x 4: w x y z, principal axes -> world */
    dem_real *angular;             /* x 4: angular momentum at the half step; shaped bodies only */
    dem_real *moment;              /* x 4: principal moments of inertia, kg m2; moment_arm, m */
    int32_t *shape;                /* dem_shape ids; 0: a sphere */
    int shaped;                    /* number of bodies that are not spheres */
    dem_real *centre;              /* x 4: member spheres: centre relative to the body's centre, and
                                      radius, m; a lone sphere is its own member */
    dem_real *ball;                /* x 4: effects.clustered: the same, with centres in space */
    dem_real *yield;               /* x 6: with springs: inverse inertia of bodies in space, xx yy
                                      zz xy xz yz, 1/(kg m2); 0: fixed, or a lone sphere */
    int32_t *centre_start;         /* first member sphere of each body */
    int centres_valid;               /* they fit the bodies and their orientations */
    uint32_t *slot;                /* of each body */
    int32_t *material;             /* 1 + index */
    int32_t *slot_index;           /* slot -> index, < 0 if free */
    uint32_t *slot_generation;
    int slot_count, slot_capacity; /* slots used so far, capacity */
    /* first of the free slots, which are linked (-1: none); pending slots become free at the next
       rebuild */
    int slot_free, slot_pending;
    int real_count;                /* user-defined numbers per body; 0: the next two are null */
    dem_real *reals, *rates;       /* x real_count; 1/s: their rates, by laws, at present forces */
    int group_count;               /* > 0: `groups` exists */
    uint32_t *groups;              /* bit k: in group k of desc.groups */
    int zoned;                     /* `zones` exists */
    uint32_t *zones;               /* bit k: in the region of counting outlet k; 16 + k: known */
    int aged, averaged;            /* `born` exists; `means` exists */
    double *born;                  /* s: when it was inserted, or measuring began (>>feed) */
    double *means;                 /* x DEMI_MEANS: averages over samples (>>fields) */
    uint8_t *ghost;              /* by slot; 1: ghost, a copy owned by another slab; null outside
                                    >>slabs */
    dem_real *scratch;             /* x 4, for permuting */
    int32_t *order, *cell_of;      /* permutation, cell of each body */
    dem_body_counts balance;
} demi_bodies;
/* Saved contact history. While a list is valid, the history of two spheres is stored in the columns
   of the pruned list; every other contact stores its own (demi_persistent). A new pruned list
   copies the columns of the previous one (near_last), pair by pair. Before a rebuild, and when
   bodies are added or removed (demi_list_drop), indices are about to change. Then the history of
   spheres is saved here, by slot, and persistent contacts store slots instead of indices. The next
   list reads the saved history (demi_near_make), and persistent contacts move to the work groups of
   their bodies (demi_persistent_move). If the two bodies of a contact exchange their roles, because
   the other one now has the lower index, vectors change sign. Nothing is discarded before the new
   list is fully allocated, so a rebuild that ran out of memory can be repeated. Checkpoints contain
   all of it. Entries start[row] .. start[row + 1] - 1 belong to the pairs whose lower slot is
   `row`. */
enum { DEMI_BALLS_MOST = 1024 };               /* > largest number of spheres of a cluster */
typedef struct demi_filed {
    int32_t *start;                /* rows + 2 */
    int32_t *partner;              /* the higher slot; its complement (~) if that was body a */
    int32_t *part;                 /* DEMI_BALLS_MOST times the member sphere of the lower slot,
                                      plus that of the higher slot */
    dem_real *memory;              /* x stride */
    int count, rows;               /* entries; number of slots when they were saved */
    int stride;                    /* reals per entry */
} demi_filed;

/* Progress of an output. Part of the state; checkpoints store the whole struct. */
typedef struct demi_written {
    uint64_t what, when;           /* digests: of its kind and path; of its start and interval */
    int64_t next;                  /* number of the next writing; DEMI_OUTPUT_UNKNOWN: the first
                                      that is due, the present time included */
    double last;                   /* s: time of the last writing; -1e300: none yet */
} demi_written;
enum { DEMI_OUTPUT_UNKNOWN = -1 };
#define DEMI_OUTPUT_MOST 9e15      /* largest number: a double holds all integers up to there */
#define DEMI_OUTPUT_LEAST 1e-12    /* s, shortest interval */
typedef struct demi_output {
    dem_output_desc desc;          /* its texts are copies that the world owns */
    demi_written written;
    int32_t id;                    /* outputs are sorted by id, ascending */
    int resumes;                   /* 1 or, if a checkpoint that was read contained it, 2: later
                                      lines of a CSV file have not been removed yet */
} demi_output;

/* The call that is running a user-defined function; who is null if none. within: 1 while lists and
   sums are incomplete, 0 where the world is consistent and files may be written. set: 1 if
   demi_calls has changed it, so that demi_called restores it. */
typedef struct demi_calling { const char *who; int within, set; } demi_calling;

/* How many threads a world uses, see demi_threads_judge. Not part of the state. */
typedef struct demi_threads {
    int now, best;                 /* threads of this step; of steps outside trials */
    int steps, turn, fixed;        /* steps measured; kind of the last trial; 1: no trials */
    double begun, sum, cost;       /* s: start of the step; time of `steps`; per step with `best` */
    double since, wait;            /* s: since the last trial, until the next one */
    uint64_t rebuilds;             /* when this step began */
} demi_threads;

/* Observers of a run: outputs, replays, progress. Not part of the state, except `written` of
   outputs: reading a checkpoint does not change them. */
typedef struct demi_lookers {
    demi_calling calling;          /* see demi_calls */
    dem_world *of;                 /* the world of the user that holds the mark: the original of a
                                      copy, the head of slabs; null: this one */
    int tenths_told;               /* progress into a file: last tenth of this run reported */
    int under_way;                 /* > 0: an output runs a user-defined function; steps fail */
    struct dem_replay *films;             /* open replays, which record frames automatically */
    void (*films_look)(dem_world *w);           /* records their frames; null: no replays */
    int output_count, reads;       /* reads: number of checkpoints read so far */
    int32_t output_last;           /* the last id given to an output */
    demi_output *outputs;
    dem_result (*outputs_look)(dem_world *w);   /* writes what is due; null: no outputs */
    void (*outputs_again)(dem_world *w);        /* called after reading a checkpoint */
} demi_lookers;

/* Data of the solvers for impulses, set up again in every step (>>impulses). demi_meeting: the
   constraint of a contact. demi_impulse: the same contact as solvers iterate over it. demi_beside:
   its data that sweeps do not need. demi_twist: its rolling and spinning friction. demi_mover:
   velocities of a body or wall point as solvers see them. demi_rod: a joint. demi_joint_node: a
   body or joint in the linear system of all joints. */
struct demi_meeting;
struct demi_impulse;
struct demi_beside;
struct demi_twist;
struct demi_mover;
struct demi_run_sums;
struct demi_rod;
struct demi_joint_node;
struct demi_link_of;
struct demi_seat;
struct demi_tree_body;
typedef struct demi_solver {
    struct demi_meeting *meetings; /* those of work group d begin at meeting_first[d] */
    struct demi_impulse *contacts; /* this and the next three are in the order of colours */
    struct demi_beside *beside;
    struct demi_twist *twists;     /* null: no rolling or spinning friction */
    dem_vec3 *arms;                /* x 2, m; null: all bodies are spheres */
    struct demi_mover *movers;     /* one per body and per persistent contact; then copies of them,
                                      for some solvers */
    dem_real *tensors;             /* x 6: inverse inertia in the world's frame; null: all bodies
                                      are spheres */
    dem_real *lifts;               /* x 4, m/s: velocities that remove overlaps, see
                                      demi_impulses_lift */
    uint64_t *colours;             /* of each body: bits of the colours of its contacts */
    int32_t *degrees;              /* of each body: its number of contacts */
    dem_vec3 *vectors;             /* work vectors of some solvers, one entry per contact */
    struct demi_run_sums *runs;    /* sums over each run of contacts, a block of one colour */
    struct demi_rod *rods;         /* one per joint */
    int32_t *joined;               /* of each body: its first joint, see demi_joined */
    struct demi_joint_node *nodes; /* unknowns of the joints' linear system: bodies and joints */
    int32_t *node_of, *rows;       /* node of each body; row of each entry of the factor */
    struct demi_link_of *links;
    double *blocks;                /* x 36: pivots of the factor, and entries below them */
    struct demi_seat *seats;       /* see >>towers */
    struct demi_tree_body *trees;  /* one per body */
    int32_t *treed;                /* bodies that have a tree */
    int seat_count, treed_count;
    int node_count, row_count, link_count, factored;
    int count, first, last, run;   /* contacts; range of the colour being swept; its first run */
    int mover_count;               /* of one array of solver bodies */
    int sweep;                     /* sweeps since the direction began */
    int limited;                   /* contacts at their friction limit in the last unsolved step */
    int twisted;                   /* 1: there is rolling or spinning friction */
    int faced, seated;             /* 1: some polyhedron lies on a face, or a tower is tall; some
                                      contact has three points or more */
    int begins[65];                /* first contact of each colour */
    int meeting_first[DEMI_DOMAINS], meeting_count[DEMI_DOMAINS];
    dem_real dt, step;             /* s; step length of some solvers */
} demi_solver;

/* A number for each body that crosses the border between two worlds of a team: its size, how it is
   read from a body and how it is added to one. */
typedef struct demi_record {
    size_t (*size)(const dem_world *member);   /* bytes of one body */
    void (*put)(const dem_world *member, int body, char *to);
    void (*take)(dem_world *member, int body, const char *from);
} demi_record;
/* A contact of the present step, as the loops over contacts note it while events are recorded. */
typedef struct demi_noted {
    int32_t a, b;                  /* bodies; b < 0: wall -1 - b */
    int32_t kind;                  /* bits DEMI_NOTED_... */
    double force;                  /* N, repulsive force along the normal */
    /* J, of this step: lost by the normal law, by sliding, by rolling; work against tangential
       forces; stored in tangential springs */
    double normal, slide, rolling, work, stored;
} demi_noted;
enum {
    DEMI_NOTED_OLD = 1,            /* the contact existed before this step */
    DEMI_NOTED_SPHERES = 2         /* two lone spheres: their centres tell where it is */
};
/* Where a contact is that is not of two lone spheres. A contact needs it when it begins or wears a
   wall. */
typedef struct demi_noted_at {
    dem_vec3 normal, arm;          /* unit, a -> b; m, from the centre of a to the contact point */
    dem_vec3 shift;                /* m, from a to its image that touches the wall */
} demi_noted_at;
/* The open contact that a note was added to, with the bodies of the note and the index of the
   member that noted it. */
typedef struct demi_matched { int32_t a, b, member, open; } demi_matched;
enum { DEMI_EVENT_AHEAD = 12 };    /* notes between prefetching sums and changing them */
/* Sums of an open contact, which each step changes. They fill a line of cache. */
typedef struct demi_sums {
    double normal, slide, rolling, work;       /* J, as in a note, over all steps so far */
    double impulse;                            /* N s */
    double stored, force, most;    /* J and N, of this step; N, the largest force of earlier ones */
} demi_sums;
/* A pair of bodies, or a body and a wall, that touch: an open contact. */
typedef struct demi_ongoing {
    dem_event event;               /* how it began */
    double due[4];                 /* impulses: normal, slide and rolling losses (J) and normal
                                      impulse (N s) of the coming step, */
    int32_t facet, none;           /* on this facet of the wall; padding, 0 */
} demi_ongoing;
/* Sums over the contacts of two materials that have ended; a <= b, indices. */
typedef struct demi_impacts {
    int32_t a, b;
    double ended, lost[4];         /* number; J: normal, slide, tangent, rolling */
    double impacts[DEM_IMPACT_BINS], losses[DEM_IMPACT_BINS], energy[DEM_IMPACT_BINS];
} demi_impacts;
/* Energies lost on the wall with this id, J. Those of its facets begin at `first` of `facets`. */
typedef struct demi_worn { int32_t id, first, count, none; double slide, normal; } demi_worn;
/* Numbers of a recording; saved and copied whole. */
typedef struct demi_event_counts {
    int32_t on, fresh;             /* 1: contacts are recorded; 1: no step has been noted yet */
    int32_t open, pending, pairs, walls, facets, none;     /* entries of the arrays below */
    double since;                  /* s, when it began */
} demi_event_counts;
/* A recording of contacts (>>events). Slabs note contacts; their head holds everything else. */
typedef struct demi_events {
    demi_event_counts n;
    dem_events_desc desc;
    demi_noted *noted;             /* of work group d: from noted_first[d] on */
    demi_noted_at *noted_at;
    int noted_first[DEMI_DOMAINS + 1], noted_count[DEMI_DOMAINS];
    demi_ongoing *open;
    demi_sums *sums;               /* of each open contact */
    uint32_t *last, turn;          /* of each: its first note in the last turn that noted it; the
                                      first note of this turn; notes are numbered through all turns,
                                      modulo 2^32 */
    demi_matched *matched, *before;            /* by notes of this turn and of the turn before; then
                                                  DEMI_EVENT_AHEAD that are 0 */
    int before_count;              /* of the turn before: its notes, */
    uint64_t rebuilds;             /* and the rebuilds of lists until then */
    int32_t *table;                /* hash table of 1 + entry of `open`; 0: none */
    int table_size, failed;        /* a power of 2; 1: memory ran out, recording has stopped */
    dem_event *pending;            /* not yet passed to the user's function */
    demi_impacts *pairs;
    demi_worn *walls;              /* by index of the wall */
    double *facets;                /* J, lost by sliding on each facet */
} demi_events;

/* The worlds that step together (>>team). A single world has no team: it is its own head and its
   only member. Slabs (>>slabs) are the members of a head, a world without bodies that holds the
   numbers they share: time, time step, skin, error. A body near a border is in two members: one
   owns it, the other has a copy, a ghost particle. */
struct demi_grades;
typedef struct demi_team {
    dem_world *head, **members;
    int count;                     /* members in this process */
    /* Runs a task on all members. If it fails in one, the next call of agree returns the result. */
    dem_result (*all)(dem_world *head, dem_result (*task)(dem_world *member));
    /* Replaces most[0 .. count - 1] by the maxima over all processes. */
    dem_result (*agree)(dem_world *head, double *most, int count);
    void (*rest)(dem_world *member);            /* stops the ghosts, before a move */
    dem_result (*rebuild)(dem_world *head);     /* chooses new ghosts and builds all lists */
    dem_result (*lend)(dem_world *head);        /* sends states from owners to ghosts */
    dem_result (*give)(dem_world *head, const demi_record *what);   /* adds numbers of ghosts to
                                                                        those of their owners */
    dem_result (*grades)(dem_world *head, struct demi_grades *g);   /* adds other processes */
    dem_result (*feed)(dem_world *head);        /* inserts grains */
    /* Sums `count` numbers that `part` finds for each member, in the order of members. */
    dem_result (*sum)(dem_world *head, void (*part)(const dem_world *member, int of, double *out),
                      int of, double *sums, int count);
} demi_team;

/* A world. Each group of fields belongs to the part named above it: that part writes them, and
   every part may read them. Further writers are named. */
struct dem_world {
    demi_team *team;               /* >>slabs; null: a single world */
    int member;                    /* index in team->members */
    /* >>world */
    dem_world_desc desc;           /* as given, with automatic choices filled in */
    dem_world_desc asked;          /* as given */
    char real_names[DEM_BODY_REALS*24];    /* body_reals of both descs point here, */
    char memory_names[DEM_LAW_MEMORY*24];     /* law_memory_names here, */
    char group_names[DEM_GROUPS*24];       /* and groups here */
    /* >>memory: error messages (demi_fail), and all allocations */
    char error[512];
    char refusal[512];             /* message of the first failed call that builds the scene */
    int refused;                   /* failed calls of that kind since dem_world_error_get */
    char refused_calls[24][32];    /* their names */
    char changes[512];             /* >>changed: what differed in the last checkpoint */
    size_t bytes;                  /* allocated */
    struct demi_block *chains[DEMI_CHAINS];
    /* numbers without pointers, saved and copied whole */
    demi_timing clock;             /* >>step; dt and its reasons: >>advice */
    demi_stages stage;             /* cleared by calls that change the scene, restored by >>step */
    demi_margin margin;            /* skin: >>rebuild; pruned list: >>near; displacements: >>step */
    demi_in_force effects;         /* >>rebuild */
    demi_levels levels;            /* >>search */
    demi_booked booked;            /* >>ledger; added, removed: >>bodies, >>feed, >>step */
    demi_strained cell;               /* >>stress; box: >>cell */
    /* >>materials */
    int material_count;
    dem_material_desc materials[DEMI_MATERIALS];
    demi_pair *pairs;              /* DEMI_MATERIALS x DEMI_MATERIALS */
    /* >>shapes */
    int shape_count;
    demi_shape *shapes;
    /* >>bodies; motion: >>integrators; forces: >>respond, >>persistent */
    demi_bodies bodies;
    demi_filed filed;
    /* >>walls; weights of facets: >>facets; poses and loads: >>step; new motions: >>steering */
    int wall_count;
    demi_wall *walls;
    double wall_fastest;           /* m/s, fastest wall point of the step */
    dem_real wall_period[3], ring_period[3];   /* m, of walls; of a ring of slabs */
    int repeating;                 /* 1: some wall repeats along a periodic axis */
    demi_threads threads;                /* >>team: threads in use */
    int facets_valid;              /* surfaces fit the walls and their motions */
    int sheeted;                   /* 1: some surface may be a sheet */
    int facets_given;              /* for tests: facets in one plane are not merged */
    int surface_count;             /* >>surfaces: joined surfaces */
    demi_wall *surfaces;
    /* >>measure, >>feed, >>placing, >>advice */
    int field_count;
    demi_field *fields;
    int feed_count, outlet_count;
    demi_feed *feeds;
    demi_outlet *outlets;
    int joint_count, joint_last;   /* >>joints: number of joints, last id */
    demi_joint *joints;
    int rail_count;                /* >>rails */
    demi_rail *rails;
    int written_count;             /* >>output: outputs in the checkpoint that was read last */
    demi_written *written;
    struct demi_sphere *crowd;     /* >>placing: occupancy tree of spheres, and its nodes */
    struct demi_crowd_node *crowd_nodes;
    dem_real *crowd_turned;        /* x 4: orientations of the bodies placed */
    double dt_share;               /* trials: factor on the automatic time step; 0: 1 */
    struct demi_press *press;      /* loads on bodies, while >>advice chooses the time step */
    struct demi_press_whole *press_whole;
    struct {                       /* s: time step that is checked; largest stable one, of this */
        double dt, limit, least;   /* world and of all its team; the body that limits it here */
        int worst;
    } pressed;
    /* >>rebuild: laws in force, work groups */
    int normal;                    /* law in force */
    demi_laws laws;                /* rows of the laws; unused with a user-defined law */
    int memory_stride, vector_mask;/* reals of contact history; bits of the vector components */
    int composed;                  /* for tests: always use one stage per law, never a fused one */
    int domain_count;
    demi_domain *domains;          /* the part that builds a list writes its counts */
    double domain_middle[DEMI_DOMAINS];    /* for demi_parallel: see demi_domains_weigh */
    /* >>search */
    dem_real image_shift[27*4];    /* m, added to b - a to reach b's nearest image */
    int32_t *cell_start;           /* first body of each cell */
    int cells[3], cell_axes[3];    /* along x, y, z; axes, the one with the fewest cells first */
    double cell_origin[3], cell_size[3];
    demi_end *lll_ends[3];
    struct demi_pair_key *lll_table;
    int32_t *lll_rows, *lll_row_start;
    int bins[3];                   /* number of bins along x, y, z: see demi_rows_bins */
    double bin_size[3];            /* m */
    int32_t *bin_of;               /* bodies x 6: for each axis the first bin and how many more */
    int32_t *bin_start, *bin_items;/* bodies of each bin, ascending */
    int lll_valid, lll_boxes, lll_size;    /* state of the linked linear list */
    /* >>lists: candidates of pairs and on walls; persistent contacts */
    demi_list own, cross;          /* pairs inside a work group; with a later group */
    int join_room;                 /* candidates that inserted bodies may add, see demi_list_join */
    int *cross_incoming_start;     /* domain_count + 1 */
    int32_t *cross_incoming;       /* entries of `cross`, by work group of b, ascending */
    dem_real *cross_force;          /* x 6: force and torque on body b of an entry */
    int cross_entries;
    int wall_stride;               /* capacity of wall candidates per work group */
    int32_t *wall_body, *wall_id, *wall_element;
    dem_real *wall_gap;            /* m, lower bound on the gap of grain and element when the list
                                      was built */
    dem_real *wall_shift;          /* x 3, m: from the grain to its image at the wall */
    int32_t *wall_cell;            /* of a tessellation that repeats: see demi_cell_shift */
    demi_walled *walled;           /* bodies (if `sheeted`) */
    unsigned char *by_sheet;       /* bodies (if `sheeted`): 1 if a sheet is among its candidates */
    demi_wall_sum *wall_sums;      /* domain_count x wall_count */
    /* if the law writes rates of user-defined numbers: domain_count x wall_count x real_count, and
       real_count for each entry of cross_force; else null */
    double *wall_rates;
    dem_real *cross_rate;
    int touching_valid;            /* the next three are large enough for the present candidates */
    demi_touching *touching;       /* contact points of one body and wall, for each work group */
    int32_t *touching_table;
    demi_link *touching_links;
    int persistent_first[DEMI_DOMAINS + 1]; /* where those of group d begin, in either list */
    demi_persistent *persistent_now, *persistent_next;
    demi_coefs_row *coefs; /* of group d from 2*persistent_first[d] on, see demi_persistent_row */
    demi_flush flush;              /* >>flush */
    /* >>near */
    demi_near near, near_last;     /* the pruned list; the previous one: a rebuild swaps the two */
    dem_real *species_coef;        /* row a*species_count + b: the DEMI_PAIR_COLUMNS coefficients of
                                      species a and b when lists were built */
    int species_vary;              /* bits of the columns that differ between pairs */
    struct demi_quiet *quiet;      /* isolation of blocks of bodies, see demi_domain_quiet */
    int near_fresh, near_due;      /* 1: being built after a search; head: some is due */
    int grown;                     /* >>growth: radii have just changed; not state */
    demi_persistent *merging;      /* >>members: contacts to merge, merging_most per work group */
    int merging_most;
    struct demi_solver solver;     /* >>impulses */
    demi_events events;            /* >>events; noted: >>noted, >>impulses-told */
    demi_lookers look;             /* >>step, >>output, >>replay */
};
/* Marks that user-defined functions run: calls that change the world then fail (demi_null) until
   demi_called gets the value returned here. `who` names the function in messages; within: 1 if
   files cannot be written either. A mark stays if there is one that forbids as much, so only the
   thread that sets a mark removes it. */
DEM_INLINE demi_calling demi_calls(const dem_world *w, const char *who, int within) {
    demi_calling *now = &((dem_world *)(w->look.of ? w->look.of : w))->look.calling;
    demi_calling was = *now;
    was.set = !was.who || within > was.within;
    if (was.set) { now->who = who; now->within = within; }
    return was;
}
DEM_INLINE void demi_called(const dem_world *w, demi_calling was) {
    if (was.set) ((dem_world *)(w->look.of ? w->look.of : w))->look.calling = was;
}
/* Every call of a user-defined function is in one of these two, as tests/calls.awk checks. The
   second is for functions that may change the world, but not step or destroy it. */
#define DEMI_USER(w, who, within, call) { \
    const demi_calling demi_was = demi_calls(w, who, within); \
    call; \
    demi_called(w, demi_was); }
#define DEMI_USER_FREE(w, call) { (w)->look.under_way++; call; (w)->look.under_way--; }
/* In a function that stands in for one of the user's, and that DEMI_USER calls. */
#define DEMI_USER_WITHIN(call) call

/* Mark what a change of the scene makes invalid; the next step makes it again (demi_stages). Lists:
   demi_list_drop does so, once it has filed the contact histories; the head of a team follows its
   members. Half-step velocities: the time step or velocities change. Forces, and therefore
   half-step velocities: something else acts on bodies. Facets: a wall comes, goes or moves
   otherwise (demi_surfaces_outdated). Linked linear list: a body comes or goes. Time step: bodies,
   materials or speeds change. */
DEM_INLINE void demi_list_outdated(dem_world *w) { w->stage.list_valid = 0; }
/* Returns 1 if the contacts of the present bodies and walls have been computed. */
DEM_INLINE int demi_contacts_known(const dem_world *w) { return w->stage.list_valid == 1; }
DEM_INLINE void demi_halves_outdated(dem_world *w) { w->stage.primed = 0; }
DEM_INLINE void demi_forces_outdated(dem_world *w) { w->stage.forces_valid = w->stage.primed = 0; }
DEM_INLINE void demi_facets_outdated(dem_world *w) { w->facets_valid = 0; }
DEM_INLINE void demi_lll_outdated(dem_world *w) { w->lll_valid = 0; }
DEM_INLINE void demi_dt_outdated(dem_world *w) { w->stage.dt_valid = 0; }
/* Called when the time step suits the scene. >>advice looks for pressed bodies from here on. */
DEM_INLINE void demi_dt_settled(dem_world *w) {
    w->clock.press_since = w->clock.steps;
    w->stage.dt_valid = 1;
}
/* Adds work of this kind (DEMI_E_...), J, to the ledger, and its magnitude to the throughput. */
DEM_INLINE void demi_work_book(dem_world *w, int what, double work) {
    w->booked.energy[what] += work;
    w->booked.throughput += fabs(work);
}
/* Called for bodies that get a speed, m/s, between two steps. The next step may rely on it. */
DEM_INLINE void demi_speed_book(dem_world *w, double speed) {
    w->booked.speed_max = DEMI_MAX(w->booked.speed_max, speed);
    w->margin.pace = DEMI_MAX(w->margin.pace, speed);
}
/* Bound of the speed at which the rotation of body i moves its surface along the normal of a
   contact, m/s; 0 for a sphere. */
DEM_INLINE dem_real demi_turn_speed(const dem_world *w, int i) {
    if (!w->bodies.shaped || !w->bodies.shape[i]) return 0;
    return demi_length(demi_at(w->bodies.spin + 4*i))*w->bodies.moment[4*i + 3];
}

/* Steps that are complete. One that ran out of memory after its move does not count yet; functions
   of the user that are called in a step see its number. */
static uint64_t demi_steps_done(const dem_world *w) {
    return w->clock.steps - (uint64_t)(w->stage.moved && !w->look.calling.who);
}

/* Returns the radius of body i, m, or of the sphere around its centre that encloses it. It stands
   beside the position, so that a search reads both at once. */
DEM_INLINE dem_real demi_radius(const dem_world *w, int i) { return w->bodies.pos[4*i + 3]; }
/* Calls a task for each work group. Marks this as a call of user-defined functions, because tasks
   on several threads cannot. */
static void demi_domains_do(dem_world *w, demi_task task) {
    const demi_calling was = demi_calls(w, "a step", 1);
    demi_parallel(w, w->threads.now, w->domain_count, w->domain_middle, task);
    demi_called(w, was);
}
/* A wall's id is its index in `walls`, from 1, plus DEMI_WALLS_MOST for every earlier wall at this
   index. So indices are reused, and the id of a removed wall stays invalid. */
enum { DEMI_WALLS_MOST = 1 << 18 };
static int demi_wall_place(dem_wall wall) { return (int)(((uint32_t)wall.id - 1)%DEMI_WALLS_MOST); }
static int demi_wall_there(const dem_world *w, dem_wall wall) {
    const int place = demi_wall_place(wall);
    return wall.id > 0 && place < w->wall_count && w->walls[place].id == wall.id &&
        w->walls[place].kind != DEMI_WALL_NONE;
}
/* True if a sieve consists of round wires or bars; others are plates. */
static int demi_sieve_wires(const dem_sieve_desc *s) {
    return s->kind == DEM_SIEVE_WIRES || s->kind == DEM_SIEVE_BARS;
}
/* Returns the largest gap, m, of a candidate: the skin and the range of the law. */
DEM_INLINE dem_real demi_cover(const dem_world *w) {
    return (dem_real)(w->margin.skin + w->margin.reach);
}
/* True if the response in force (springs or impulses) has this trait. */
DEM_INLINE int demi_response_is(const dem_world *w, int trait) {
    return (demi_response_kinds[w->desc.response].traits & trait) != 0;
}
/* True if margin.reach follows from the speeds, as with impulses and no law_range. Then no check
   may reject a scene because of it. */
DEM_INLINE int demi_reach_free(const dem_world *w) {
    return demi_response_is(w, DEMI_FORESEEN) && !(w->desc.law_range > 0);
}
/* The spheres of entry `at` of the pruned neighbour list, which may be members of clusters: side 0
   of body a, 1 of body b. Centre as seen from that of the body, m, and radius, m. */
DEM_INLINE dem_vec3 demi_near_arm(const dem_world *w, size_t at, int side) {
    const int32_t *ball = side ? w->near.ball_b : w->near.ball_a;
    return w->effects.clustered ? demi_at(w->bodies.centre + 4*ball[at]) : demi_v(0, 0, 0);
}
DEM_INLINE dem_real demi_near_radius(const dem_world *w, size_t at, int side) {
    const int32_t *ball = side ? w->near.ball_b : w->near.ball_a;
    return w->effects.clustered ? w->bodies.centre[4*ball[at] + 3]
        : demi_radius(w, (side ? w->near.b : w->near.a)[at]);
}
/* Vector, m, from the centre of a body to the image of the other in entry `at`; and that from the
   centre of sphere a to the image of sphere b. */
DEM_INLINE dem_vec3 demi_near_bodies_way(const dem_world *w, size_t at) {
    const dem_real *x = w->bodies.pos + 4*w->near.a[at], *y = w->bodies.pos + 4*w->near.b[at];
    return demi_add(demi_sub(demi_at(y), demi_at(x)), demi_at(w->image_shift + w->near.image[at]));
}
DEM_INLINE dem_vec3 demi_near_way(const dem_world *w, size_t at) {
    const dem_vec3 way = demi_near_bodies_way(w, at);
    return w->effects.clustered
        ? demi_add(way, demi_sub(demi_near_arm(w, at, 1), demi_near_arm(w, at, 0))) : way;
}
/* With impulses: 1 if body a is half a step ahead and b is not, having just been set, -1 if only b
   is, otherwise 0 (demi_move_midpoint). A fixed body is where it is at any time. */
DEM_INLINE int demi_pair_late(const dem_world *w, int a, int b) {
    if (!demi_response_is(w, DEMI_MIDWAY) || w->bodies.went[a] == w->bodies.went[b] ||
        !(w->bodies.inv_mass[a] > 0 && w->bodies.inv_mass[b] > 0)) return 0;
    return w->bodies.went[a] ? 1 : -1;
}
/* The vector `way` between the bodies of entry `at` at the time of the one that was just set. */
DEM_INLINE dem_vec3 demi_near_level(const dem_world *w, size_t at, dem_vec3 way) {
    const int a = w->near.a[at], b = w->near.b[at], late = demi_pair_late(w, a, b);
    return late ? demi_add(way, demi_scale(demi_at(w->bodies.vel + 4*(late > 0 ? a : b)),
                                           (dem_real)late*w->clock.dt/2)) : way;
}
/* True if the law may write rates of the user-defined numbers of bodies. */
DEM_INLINE int demi_exchanges(const dem_world *w) {
    return w->bodies.real_count > 0 && w->desc.law_who;
}
/* Returns three times the distance, m, that the fastest points of a body and of a wall together
   move in a step, with the speed that gravity adds. */
static double demi_three_steps(const dem_world *w) {
    const double dt = (double)w->desc.dt, kick = (double)demi_length(w->desc.gravity)*dt;
    return 3*(w->margin.pace + w->margin.walls_pace + kick)*dt;
}
/* Returns the gap, m, below which contacts of any two bodies are found in this step. With impulses
   it is at least a hundredth of the largest radius. */
static double demi_foreseen(const dem_world *w) {
    const double least = 0.01*(double)w->effects.radius_max;
    if (!demi_reach_free(w)) return w->margin.reach;
    return DEMI_MIN(w->margin.reach, DEMI_MAX(demi_three_steps(w), least));
}
/* Gap, m, of a pair of the pruned list that makes no use of its span. */
DEM_INLINE dem_real demi_near_margin(const dem_world *w) {
    return (dem_real)(w->margin.cover + w->margin.slack);
}
/* Returns the gap, m, below which the law is called. `radii`: sum of both radii; with a wall, the
   radius of the body. 0: the law is called only in contact. */
DEM_INLINE dem_real demi_range(const dem_world *w, dem_real radii) {
    if (demi_reach_free(w)) return (dem_real)w->margin.seen;
    return w->margin.reach > 0 ? w->desc.law_range + w->desc.law_range_radii*radii : 0;
}
/* Returns the energy `what`, J, of the coming step, summed over all domains. */
static double demi_sum_energy(const dem_world *w, int what) {
    double sum = 0;
    int d;
    for (d = 0; d < w->domain_count; d++) sum += w->domains[d].energy[what];
    return sum;
}
