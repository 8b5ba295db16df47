/* ---------------------------------------------------------------------------------------------
   >>features
   What optional features add to a step: a row of functions for each, null where it adds nothing.
   A step (>>step) runs its phases over all rows that are on, in this order, and knows no feature by
   name. h is the head of a team or a single world; w is a member.
   --------------------------------------------------------------------------------------------- */
typedef struct demi_feature {
    const char *name;
    int (*on)(const dem_world *h);
    dem_result (*ready)(dem_world *h);          /* before a step: bodies may come, go or change; the
                                                   time step is then settled again */
    dem_result (*lead)(dem_world *h);           /* before bodies move: speeds are chosen */
    void (*moved)(dem_world *w);                /* bodies have moved, time has not passed */
    dem_result (*found)(dem_world *h);          /* contacts are found, forces are computed next */
    dem_result (*answered)(dem_world *h);       /* forces are computed */
    void (*acted)(dem_world *w);                /* forces on bodies are summed; may change them */
    dem_result (*ended)(dem_world *h);          /* the step is complete */
} demi_feature;
static const demi_feature demi_features[] = {
    {"feeds",  demi_feeds_on,  demi_feeds_ready, 0, 0, 0, 0, 0, 0},
    {"growth", demi_growth_on, demi_radii_grow, 0, 0, 0, 0, 0, 0},
    {"servo",  demi_servos_on, 0, demi_servos_lead, 0, 0, 0, 0, 0},
    {"rails",  demi_rails_on,  0, 0, demi_rails_move, 0, 0, demi_rails_act, 0},
    {"cell",   demi_cell_on,   0, demi_cell_lead, demi_cell_move, 0, 0, 0, 0},
    {"events", demi_events_on, 0, 0, 0, demi_events_ready, demi_events_taken, 0, 0},
    {"fields", demi_fields_on, 0, 0, 0, 0, 0, 0, demi_fields_ended},
};
enum { DEMI_FEATURES = sizeof demi_features/sizeof *demi_features };
/* Runs a phase of all rows that are on, until one fails; that of member phases cannot fail. */
#define DEMI_PHASE(h, result, phase) \
    { \
        int row; \
        for (row = 0; row < DEMI_FEATURES && result == DEM_OK; row++) \
            if (demi_features[row].phase && demi_features[row].on(h)) \
                result = demi_features[row].phase(h); \
    }
#define DEMI_MEMBER_PHASE(w, phase) \
    { \
        int row; \
        for (row = 0; row < DEMI_FEATURES; row++) \
            if (demi_features[row].phase && demi_features[row].on(w)) demi_features[row].phase(w); \
    }
