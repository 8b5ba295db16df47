/* ---------------------------------------------------------------------------------------------
   >>pairs
   Contacts of lone spheres: the loop over the pruned neighbour list, which holds their histories. A
   tile is a run of consecutive entries.
   --------------------------------------------------------------------------------------------- */

/* Fills rows that no stage sets: coefficients that are the same for all pairs, and zero
   friction. */
static void demi_tile_begin(const dem_world *w, int d, demi_tile *t) {
    const demi_domain *domain = &w->domains[d];
    const int first = demi_near_first(domain);
    dem_real coef[DEMI_TILE_COLUMNS];
    int e, q;
    t->row = -1;
    for (q = 0; q < DEMI_TILE && !demi_laws_precise(w); q++)
        t->slope[0][q] = t->slope[1][q] = t->kt[1][q] = (dem_real)NAN;
    if (first < domain->near_end) {
        const demi_span one = demi_span_of(w, d, first, 1);
        demi_span_coefs(w, &one, 0, coef);
        if (!demi_laws_sized(w)) coef[DEMI_R_EFF] = coef[DEMI_M_EFF] = (dem_real)NAN;
        for (e = 0; e < DEMI_TILE_COLUMNS; e++)
            for (q = 0; q < DEMI_TILE; q++) t->coef[e][q] = coef[e];
    }
    memset(t->part, 0, sizeof t->part);
    memset(t->tangent, 0, sizeof t->tangent);
    memset(t->memory[DEMI_MEMORY], 0, sizeof t->memory[0]);
}
/* Copies the coefficients of a tile's pairs, except those that never vary (species_vary), which
   demi_tile_begin has set. Returns the run to use: run[0] for pairs of different bodies, run[1] for
   pairs of identical ones, which needs no radii, no differences of spins and one torque for both.
   If all pairs share one row of the table, later tiles with the same row skip the copy. Such a row
   is therefore copied to the end of the tile, since those tiles may be longer. */
static demi_run *demi_tile_coefs(const dem_world *w, const demi_span *span, int full,
                                 demi_tile *DEMI_RESTRICT t, demi_run *run) {
    const int32_t *DEMI_RESTRICT row = span->row;
    const int n = w->effects.species_count;
    int e, q, differ = 0, same;
    if (w->effects.uniform) return run + 1;
    for (q = 0; q < full && row; q++) differ |= row[q]^row[0];
    same = row && !differ;
    for (e = 0; e < DEMI_TILE_COLUMNS && !(same && t->row == row[0]); e++) {
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

/* A cell that deforms: adds the velocity difference of its flow to a row of relative velocities.
   branch: m, from the centre of body a to that of b. */
DEM_INLINE void demi_rows_flow(const dem_world *w, demi_rows *rate, int q, dem_vec3 branch) {
    const dem_vec3 flow = demi_cell_flow(w, branch);
    DEMI_XY(rate, 0, q) -= flow.x;
    DEMI_XY(rate, 1, q) -= flow.y;
    rate->z[q] -= flow.z;
}
/* The same for all pairs of a tile. */
static DEMI_APART void demi_tile_flow(const demi_run *r, int count, demi_tile *t) {
    int q;
    for (q = 0; q < count; q++) {
        demi_rows_flow(r->w, &t->rate, q, demi_rows_at(&t->gap, q));
        if (r->following) demi_rows_flow(r->w, &t->gone, q, demi_rows_at(&t->gap, q));
    }
}
/* Evaluates a tile with one of two runs, and returns that run. */
static demi_run *demi_tile_respond(const dem_world *w, const demi_span *span, demi_run *run,
                                   demi_tile *DEMI_RESTRICT t) {
    const int full = (span->count + DEMI_LANES - 1)/DEMI_LANES*DEMI_LANES;
    demi_run *r = demi_tile_coefs(w, span, full, t, run);
    int q, k;
    r->span = span;
    for (q = 0; q < r->keep; q++)
        demi_row_copy(t->memory[q], span->memory + (size_t)q*span->stride, full);
    demi_tile_fetch(r, full, t);
    if (w->cell.on) demi_tile_flow(r, full, t);
    for (k = 0; k < DEMI_STAGES && r->stage[k]; k++) r->stage[k](t, r, full);
    for (q = 0; q < r->keep; q++) {             /* `count` only: others may follow */
        dem_real *memory = span->memory + (size_t)q*span->stride;
        demi_row_copy(memory, t->memory[q], span->count/DEMI_LANES*DEMI_LANES);
        for (k = span->count/DEMI_LANES*DEMI_LANES; k < span->count; k++)
            memory[k] = t->memory[q][k];
    }
    return r;
}

/* Computes all pairs of a work group: those inside it, then those with later groups. In a world
   with clusters it computes pairs of two lone spheres only; demi_pairs_members computes the
   others. */
static void demi_pairs(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    const dem_real dt = w->stage.forces_valid ? w->clock.dt : 0;           /* 0: forces only */
    demi_run run[2];
    DEMI_ALIGNED demi_tile tile;
    int l, p;
    domain->contacts = 0;
    if (domain->near_own <= 0 && domain->near_end <= domain->near_cross) return;
    run[0] = demi_run_of(w, dt, 0);
    run[1] = demi_run_of(w, dt, 1);
    demi_tile_begin(w, d, &tile);
    for (l = 0; l < 2; l++) {
        const int begin = l ? domain->near_cross : 0;
        const int end = w->effects.clustered ? begin + domain->near_lone[l]
            : l ? domain->near_end : domain->near_own;
        for (p = begin; p < end; p += DEMI_TILE) {
            const int count = DEMI_MIN((int)DEMI_TILE, end - p);
            const demi_span span = demi_span_of(w, d, p, count);
            const demi_run *r = demi_tile_respond(w, &span, run, &tile);
            demi_tile_tally(&tile, count, r->ranged, domain);
            demi_tile_finish(w, d, &tile, &span, r, l);
        }
    }
}

#if defined(__GNUC__) && !defined(__clang__) && !defined(__TINYC__)
#pragma GCC pop_options
#endif
