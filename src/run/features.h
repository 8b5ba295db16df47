/* ---------------------------------------------------------------------------------------------
   >>features
   What optional features add to a step, to a checkpoint and to slabs: a row of functions for each,
   null where it adds nothing. A step (>>step) runs its phases over all rows that are on, in this
   order; checkpoints and slabs run theirs over all rows. None of them knows a feature by name. h is
   the head of a team or a single world; w is a member.
   --------------------------------------------------------------------------------------------- */
typedef struct demi_feature {
    const char *name;
    int (*on)(const dem_world *h);              /* null: always */
    dem_result (*ready)(dem_world *h);          /* before a step: bodies may come, go or change; the
                                                   time step is then settled again */
    dem_result (*lead)(dem_world *h);           /* before bodies move: speeds are chosen */
    void (*moved)(dem_world *w);                /* bodies have moved, time has not passed */
    dem_result (*found)(dem_world *h);          /* contacts are found, forces are computed next */
    dem_result (*answered)(dem_world *h);       /* forces are computed */
    void (*acted)(dem_world *w);                /* forces on bodies are summed; may change them */
    dem_result (*ended)(dem_world *h);          /* the step is complete */
    /* a checkpoint; t: the world that is read */
    void (*visit)(dem_world *w, demi_stream *s);        /* writes or reads the state */
    int (*counts)(const demi_reader *r);        /* 0 with a message: an impossible count */
    int (*room)(dem_world *t);                  /* allocates; 0: memory ran out */
    int (*sane)(const demi_reader *r);          /* 0 with a message: an impossible value */
    void (*resumed)(dem_world *t);              /* computes what follows from the state */
    /* slabs */
    dem_result (*whole)(dem_world *w, const char *call);       /* fails if slabs cannot have it */
    int (*share)(dem_world *slab, const dem_world *from, int first);   /* copies what each slab has;
                                                   first: to the first one; 0: memory ran out */
} demi_feature;
#ifdef DEM_NO_IMPULSES
#define DEMI_JOINTS_FEATURE
#else
#define DEMI_JOINTS_FEATURE \
    {"joints", 0, 0, 0, 0, 0, 0, 0, 0, \
     demi_joints_visit, 0, demi_joints_grow, demi_joints_check, 0, 0, 0},
#endif
/* >>add-feature: add a row here and its functions above. */
static const demi_feature demi_features[] = {
    DEMI_JOINTS_FEATURE
    {"feeds",  demi_feeds_on,  demi_feeds_ready, 0, 0, 0, 0, 0, 0,
     demi_feeds_visit, 0, 0, demi_feeds_check, 0, 0, 0},
    {"outlets", 0, 0, 0, 0, 0, 0, 0, 0,
     demi_outlets_visit, 0, 0, 0, 0, 0, demi_outlets_share},
    {"growth", demi_growth_on, demi_radii_grow, 0, 0, 0, 0, 0, 0,
     0, 0, 0, 0, 0, 0, 0},
    {"servo",  0, 0, demi_servos_lead, 0, 0, 0, 0, 0,
     0, 0, 0, 0, 0, 0, 0},
    {"rails",  demi_rails_on,  0, 0, demi_rails_move, 0, 0, demi_rails_act, 0,
     demi_rails_visit, demi_rails_counts, demi_rails_grow, demi_rails_check, 0,
     demi_rails_whole, 0},
    {"cell",   demi_cell_on,   0, demi_cell_lead, demi_cell_move, 0, 0, 0, 0,
     0, 0, 0, 0, 0, demi_cell_whole, 0},
    {"events", demi_events_on, 0, 0, 0, demi_events_ready, demi_events_taken, 0, 0,
     demi_events_visit, demi_events_counts, demi_events_reserve, demi_events_check,
     demi_events_index, 0, demi_events_share},
    {"fields", demi_fields_on, 0, 0, 0, 0, 0, 0, demi_fields_ended,
     demi_fields_visit, 0, 0, demi_fields_check, 0, demi_fields_whole, demi_fields_share}};
enum { DEMI_FEATURES = sizeof demi_features/sizeof *demi_features };
#define DEMI_FEATURE_ON(row, h) (!demi_features[row].on || demi_features[row].on(h))
/* Runs a phase of all rows that are on, until one fails; that of member phases cannot fail. */
#define DEMI_PHASE(h, result, phase) \
    { \
        int row; \
        for (row = 0; row < DEMI_FEATURES && result == DEM_OK; row++) \
            if (demi_features[row].phase && DEMI_FEATURE_ON(row, h)) \
                result = demi_features[row].phase(h); \
    }
#define DEMI_MEMBER_PHASE(w, phase) \
    { \
        int row; \
        for (row = 0; row < DEMI_FEATURES; row++) \
            if (demi_features[row].phase && DEMI_FEATURE_ON(row, w)) demi_features[row].phase(w); \
    }
/* Calls the function of a column of all rows that have one. */
#define DEMI_ALL_FEATURES(column, arguments) \
    { \
        int row; \
        for (row = 0; row < DEMI_FEATURES; row++) \
            if (demi_features[row].column) demi_features[row].column arguments; \
    }
