/* ---------------------------------------------------------------------------------------------
   >>pairs
   Contacts of spheres to forces and torques: user-defined laws, the choice of stages, and the loop
   over the pruned neighbour list. A scene runs only the stages that it needs, so any combination of
   laws costs the sum of its parts. The forces of a tile are added to both bodies. A pair with a
   body of a later work group stores that force in a slot; the other work group adds it once all are
   done, in list order. The order of every sum is thus independent of the number of threads.
   --------------------------------------------------------------------------------------------- */

/* Fills in `who` for a law that has desc.law_who set, for bodies a and b; b < 0: wall -1 - b, of
   which the grains have the radius rb. arm: m, from a's centre to the contact point. */
static void demi_who_fill(const dem_world *w, int a, int b, dem_real ra, dem_real rb, dem_vec3 arm,
                          dem_real *rates, dem_contact_who *who) {
    const demi_periods periods = demi_periods_of(w);
    who->a = dem_body_id_get(w, a);
    who->radius_a = ra;
    who->mass_a = w->bodies.mass[a];
    who->radius_b = rb;
    if (b >= 0) who->b = dem_body_id_get(w, b);
    if (b >= 0) who->mass_b = w->bodies.mass[b];
    who->point = demi_place_of(&periods, demi_add(demi_at(w->bodies.pos + 4*a), arm));
    who->time = w->clock.time;
    demi_who_reals(w, a, DEMI_MAX(b, -1), b < 0 ? -1 - b : 0, rates, who);
}
/* The same for pair q. */
static DEMI_APART void demi_tile_who(const demi_tile *t, const demi_run *r, int q,
                                     dem_real *rates, dem_contact *c) {
    const dem_real ra = t->radius[0][q], rb = t->radius[1][q];
    const dem_vec3 arm = demi_scale(demi_rows_at(&t->gap, q), ra/(ra + rb));
    demi_who_fill(r->w, r->span->a[q], r->span->b[q], ra, rb, r->span->ball ? demi_add(arm,
        demi_at(r->w->bodies.centre + 4*r->span->ball[q])) : arm, rates, &c->who);
}
/* Fills a dem_contact from row q for a user-defined law. */
DEM_INLINE void demi_tile_own(demi_tile *DEMI_RESTRICT t, const demi_run *r, const demi_same *same,
                              int q, int who, dem_contact *c) {
    const dem_world *w = r->w;
    demi_tile_contact(t, same, q, c);
    c->range = r->ranged ? demi_tile_range(t, same, q, 0) : 0;
    c->material_a = w->bodies.material[r->span->a[q]];
    c->material_b = w->bodies.material[r->span->b[q]];
    c->user = w->desc.law_user;
    if (who) demi_tile_who(t, r, q, t->gains[q], c);
}
/* Calls the user-defined law for pair q. */
DEM_INLINE void demi_own_one(demi_tile *DEMI_RESTRICT t, const demi_run *r, const demi_same *same,
                             int q, dem_contact *c) {
    const dem_world *w = r->w;
    const int keep = w->desc.law_memory;
    dem_contact_force f;
    dem_real m[DEMI_MEMORY];
    demi_tile_own(t, r, same, q, w->desc.law_who, c);
    demi_force_clear(&f);
    demi_recall(t, q, 0, keep, m);
    DEMI_USER(w, "the evaluation of contacts", 1, w->desc.law(c, m, &f))
    demi_keep(t, q, 0, keep, m);
    if (same->at_sliding < DEMI_MEMORY) t->memory[same->at_sliding][q] = f.sliding*t->touch[q];
    demi_answer_one(t, q, f.normal, f.tangent, f.moment, r->alike, 1, 1);
    if (!r->ledger) return;                        /* energies that the law returned */
    demi_normal_energy(t, q, &f);
    demi_tangent_energy(t, q, &f);
    t->part[5][q] = f.energy.roll*t->touch[q];
}
#define DEMI_COEF_COLUMN(PROPERTY, COEFFICIENT, UNIT) \
    c.COEFFICIENT = t->coef[DEMI_COEF_##COEFFICIENT];
/* Calls a user-defined law pair by pair, and only for pairs in contact or within its range. */
static void demi_stage_own(demi_tile *DEMI_RESTRICT t, const demi_run *r, int full) {
    const demi_same same = r->same;
    dem_contact c;
    int q, e;
    (void)full;
    demi_who_clear(&c.who);
    for (q = 0; q < r->span->count; q++) {
        if (t->touch[q] > 0) {
            demi_own_one(t, r, &same, q, &c);
            continue;
        }
        demi_row_put(t->force, q, demi_v(0, 0, 0));
        demi_row_put(t->torque[0], q, demi_v(0, 0, 0));
        demi_row_put(t->torque[1], q, demi_v(0, 0, 0));
        for (e = 0; e < r->keep; e++) t->memory[e][q] = 0;
        for (e = 0; e < 7; e++) t->part[e][q] = 0;
    }
}
/* The law for rows of contacts: the one of the desc, or made of the law that DEM_LAW names. Null if
   the world calls its law contact by contact. */
#ifdef DEM_LAW
DEM_LAW_ROWS(demi_own_0, DEM_LAW, 0)
DEM_LAW_ROWS(demi_own_3, DEM_LAW, 3)
DEM_LAW_ROWS(demi_own_4, DEM_LAW, 4)
DEM_LAW_ROWS(demi_own_any, DEM_LAW, rows->memory_count)
#endif
static dem_law_rows_fn demi_own_rows(const dem_world *w) {
    if (!w->desc.law || w->desc.law_who) return 0;
#ifdef DEM_LAW
    if (w->desc.law == DEM_LAW)
        switch (w->desc.law_memory) {
        case 0: return demi_own_0;
        case 3: return demi_own_3;
        case 4: return demi_own_4;
        default: return demi_own_any;
        }
#endif
    return w->desc.law_rows;
}
/* Passes the columns of a tile to the law, after those that stages store otherwise. */
static void demi_stage_own_rows(demi_tile *DEMI_RESTRICT t, const demi_run *r, int full) {
    static const int energies[7] = {0, 6, 1, 2, 3, 4, 5};       /* rows of part */
    const dem_world *w = r->w;
    const demi_same same = r->same;
    dem_real spin[3][DEMI_ROOM], spin_step[3][DEMI_ROOM], range[DEMI_ROOM];
    int32_t material[2][DEMI_ROOM];
    dem_contact_rows c;
    int e;
    DEMI_ROWS(full)
        demi_row_put(spin, q, demi_rows_at(&t->apart, q));
        demi_row_put(spin_step, q, demi_rows_at(&t->parted, q));
    DEMI_ROWS_END
    for (e = 0; e < full; e++) {
        material[0][e] = w->bodies.material[r->span->a[e]];
        material[1][e] = w->bodies.material[r->span->b[e]];
        range[e] = r->ranged ? demi_tile_range(t, &same, e, 0) : 0;
    }
    c.count = full;
    c.memory_count = w->desc.law_memory;
    c.touch = t->touch; c.overlap = t->overlap; c.range = range; c.closing_speed = t->closing;
    c.twist = t->twist; c.sliding = t->memory[same.at_sliding];
    for (e = 0; e < 3; e++) {
        c.normal[e] = t->normal[e]; c.normal_rate[e] = t->turn[e];
        c.slip[e] = t->slip[e]; c.slip_step[e] = t->slip_step[e];
        c.spin[e] = spin[e]; c.spin_step[e] = spin_step[e];
        c.tangent[e] = t->tangent[e]; c.moment[e] = t->moment[e];
    }
    c.r_eff = t->coef[DEMI_R_EFF]; c.m_eff = t->coef[DEMI_M_EFF];
    c.kn = t->coef[DEMI_KN]; c.cn = t->coef[DEMI_CN];
    c.kt = t->coef[DEMI_KT]; c.ct = t->coef[DEMI_CT]; c.kun = t->coef[DEMI_K_UN];
    c.friction = t->coef[DEMI_MU]; c.friction_static = t->coef[DEMI_MU_STATIC];
    c.rolling_friction = t->coef[DEMI_MU_ROLL]; c.spinning_friction = t->coef[DEMI_MU_SPIN];
    c.material_a = material[0]; c.material_b = material[1];
    DEM_LAW_COEFFICIENTS(DEMI_COEF_COLUMN)
    c.dt = same.dt; c.tension = same.tension; c.friction_load = same.friction_load;
    c.slider = same.slider; c.user = w->desc.law_user;
    for (e = 0; e < DEM_LAW_MEMORY; e++) c.memory[e] = t->memory[e];
    c.normal_force = t->repulsion;
    c.slides = t->memory[same.at_sliding];
    if (same.at_sliding == DEMI_MEMORY) memset(c.slides, 0, sizeof t->memory[0]);   /* of no pair */
    for (e = 0; e < 7; e++) c.energy[e] = r->ledger ? t->part[energies[e]] : 0;
    DEMI_USER(w, "the evaluation of contacts", 1, demi_own_rows(w)(&c))
    demi_answer_choose(r, 1)(t, r, full);
}

/* --- choice of stages --- */
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

/* Returns the one stage that evaluates all laws of the scene, or null if there is none. */
static demi_stage demi_whole_stage(const dem_world *w, int alike) {
    (void)alike;
    if (w->desc.law) return demi_own_rows(w) ? demi_stage_own_rows : demi_stage_own;
#ifndef DEM_NO_SPECIALIZE
    if (w->composed || w->effects.twisting || !demi_laws_usual(w) ||
        w->normal != DEM_NORMAL_HERTZ) return 0;
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
/* Appends the stages of the scene's laws from stage k on. Returns the number of stages then. */
static int demi_run_laws(const dem_world *w, demi_run *r, int k) {
    const demi_stage_row *normal = &demi_normal_stages[w->normal];
    const demi_stage_row *tangent = &demi_tangent_stages[w->effects.tangent];
    const int all = w->desc.ledger || !demi_laws_usual(w);
    r->stage[k++] = all ? normal->all : demi_laws_precise(w) ? normal->precise : normal->common;
    if (w->laws.tangent->law) r->stage[k++] = all ? tangent->all : tangent->common;
    if (w->laws.rolling->law) r->stage[k++] = demi_rolling_stages[w->effects.rolling].common;
    if (w->effects.twisting) r->stage[k++] = demi_stage_twist;
    return k;
}
/* Returns a run for the laws in force, without stages. dt 0: forces only, history does not
   advance. */
static demi_run demi_run_begin(const dem_world *w, dem_real dt) {
    const demi_laws *laws = &w->laws;
    const int own = w->desc.law != 0, rolls = demi_laws_roll(w);
    demi_run r;
    memset(&r, 0, sizeof r);
    r.w = w;
    r.ledger = w->desc.ledger; r.keep = w->memory_stride;
    r.usual = demi_laws_usual(w);
    r.turning = own || rolls || laws->tangent->law;
    r.parting = own || rolls;
    r.following = own || laws->tangent->vectors || laws->rolling->vectors || w->effects.twisting;
    r.ranged = w->margin.reach > 0;
    r.same.range = w->desc.law_range;
    r.same.range_radii = w->desc.law_range_radii;
    r.same.at_rolling = laws->at_rolling; r.same.at_normal = laws->at_normal;
    r.same.at_sliding = laws->at_sliding;
    r.same.at_twisting = laws->at_twisting; r.same.rolls = laws->rolling->law != 0;
    r.same.tension = (int)w->desc.tension;
    r.same.friction_load = (int)w->desc.friction_load;
    r.same.slider = (int)w->desc.slider;
    r.same.dt = dt;
    return r;
}
/* Returns the run for contacts of two spheres. alike: for pairs of identical bodies; it gives the
   same bits as the general one. */
static demi_run demi_run_of(const dem_world *w, dem_real dt, int alike) {
    const demi_stage whole = demi_whole_stage(w, alike);
    demi_run r = demi_run_begin(w, dt);
    int k = 0;
    r.alike = alike;
    r.parting |= r.turning && !alike;
    r.same.radius = w->effects.species[0].radius;
    r.same.inv_radius = 1/r.same.radius;
    r.stage[k++] = r.ranged ? demi_stage_mixed_ranged
        : r.following ? r.alike ? demi_stage_alike_following : demi_stage_mixed_following
        : r.turning ? r.alike ? demi_stage_alike_turning : demi_stage_mixed_turning
        : r.alike ? demi_stage_alike_bare : demi_stage_mixed_bare;
    if (whole) { r.stage[k] = whole; return r; }
    k = demi_run_laws(w, &r, k);
    r.stage[k] = demi_answer_choose(&r, demi_laws_roll(w));
    return r;
}
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

/* Corrects the energy that dashpots took to the velocities of the actual path. */
static void demi_tile_late(const dem_world *w, const demi_span *span, int full,
                           demi_tile *DEMI_RESTRICT t) {
    const dem_real *DEMI_RESTRICT late = w->bodies.late;
    int n;
    for (n = 0; n < span->count; n++)
        demi_rows_minus(&t->late, (size_t)n, DEMI_AT(late, span->a[n]), DEMI_AT(late, span->b[n]));
    DEMI_ROWS(full)
        t->part[0][q] *= 1 + demi_late_share(demi_rows_at(&t->late, q), demi_row(t->normal, q),
                                             t->closing[q]);
    DEMI_ROWS_END
}
/* Adds the energies of a tile's contacts to the ledger, in list order. */
static void demi_tile_book(const demi_tile *DEMI_RESTRICT t, int count, double *energy) {
    int q;
    for (q = 0; q < count; q++) {
        energy[DEMI_E_DASHPOT] += (double)(t->part[0][q] + t->part[6][q]);
        energy[DEMI_E_ELASTIC] += (double)t->part[1][q];
        energy[DEMI_E_SHEAR_WORK] += (double)t->part[2][q];
        energy[DEMI_E_SLIDE] += (double)t->part[3][q];
        energy[DEMI_E_SHEAR_STORED] += (double)t->part[4][q];
        energy[DEMI_E_ROLL] += (double)t->part[5][q];
    }
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
    for (q = 0; q < r->keep; q++) {             /* `count` only: pairs of >>members may follow */
        dem_real *memory = span->memory + (size_t)q*span->stride;
        demi_row_copy(memory, t->memory[q], span->count/DEMI_LANES*DEMI_LANES);
        for (k = span->count/DEMI_LANES*DEMI_LANES; k < span->count; k++)
            memory[k] = t->memory[q][k];
    }
    return r;
}

/* Adds the contacts of a tile to the number and the largest relative overlap of its work group.
   ranged: contacts also act across a gap, and those that do so do not count. */
static void demi_tile_tally(const demi_tile *DEMI_RESTRICT t, int count, int ranged,
                            demi_domain *sum) {
    dem_real deepest = 0, contacts = 0;
    int q;
    for (q = 0; q < count; q++) {
        deepest = t->deep[q] > deepest ? t->deep[q] : deepest;
        contacts += t->touch[q];
    }
    for (q = 0; q < count && ranged; q++) contacts -= t->touch[q] > 0 && !(t->overlap[q] > 0);
    sum->contacts += (int)contacts;
    sum->overlap = DEMI_MAX(sum->overlap, (double)deepest);
}
DEM_INLINE void demi_sum_add(dem_real *sum, dem_real x, dem_real y, dem_real z) {
    x += sum[0]; y += sum[1]; z += sum[2];
    sum[0] = x; sum[1] = y; sum[2] = z;
}
DEM_INLINE void demi_force_add(dem_real *sum, dem_vec3 f) {
    sum[0] += f.x; sum[1] += f.y; sum[2] += f.z;
}
/* Adds a tile's forces to both bodies. */
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
/* Adds a tile's forces to both bodies in list order, which decides the bits of the sums. */
static void demi_tile_scatter(demi_tile *DEMI_RESTRICT t, const demi_span *span,
                              const demi_run *r, dem_real *DEMI_RESTRICT force,
                              dem_real *DEMI_RESTRICT torque) {
    if (r->parting || span->ball) demi_scatter(t, span, force, torque, 1, 1);
    else if (r->turning) demi_scatter(t, span, force, torque, 1, 0);
    else demi_scatter(t, span, force, torque, 0, 0);
}
/* The same for pairs with later work groups: forces on b stay in slots `out`, six reals for each
   candidate. Several pairs of clusters add to one slot, which was cleared before. */
static void demi_tile_send(demi_tile *DEMI_RESTRICT t, const demi_span *span,
                               const demi_run *r, dem_real *DEMI_RESTRICT force,
                               dem_real *DEMI_RESTRICT torque, dem_real *DEMI_RESTRICT slots) {
    const int turning = r->turning || span->ball, second = r->parting || span->ball;
    int q;
    for (q = 0; q < span->count; q++) {
        dem_real *out = slots + 6*(size_t)span->k[q];
        const dem_vec3 f = demi_row(t->force, q);
        demi_force_add(DEMI_AT(force, span->a[q]), f);
        if (turning) demi_force_add(DEMI_AT(torque, span->a[q]), demi_row(t->torque[0], q));
        if (span->ball) {
            demi_force_add(out, demi_scale(f, -1));
            demi_force_add(out + 3, demi_row(t->torque[1], q));
            continue;
        }
        out[0] = -f.x; out[1] = -f.y; out[2] = -f.z;
        if (turning) demi_put(out + 3, demi_row(t->torque[second], q));
    }
}

/* Adds the rates that a law returned for user-defined numbers to both bodies. out: the slots for
   those of b, if b is of a later work group. */
static DEMI_APART void demi_tile_rates(const demi_tile *t, const demi_span *span, dem_world *w,
                                       dem_real *out) {
    const int n = w->bodies.real_count;
    int q, k;
    for (q = 0; q < span->count; q++) {
        dem_real *a = w->bodies.rates + n*span->a[q];
        dem_real *b = out ? out + (size_t)n*(size_t)span->k[q] : w->bodies.rates + n*span->b[q];
        const int touch = t->touch[q] > 0, sets = out && !span->ball;
        const dem_real share = span->share ? span->share[q] : 1;
        for (k = 0; k < n; k++) {
            if (touch) a[k] += share*t->gains[q][k];
            if (sets) b[k] = touch ? t->gains[q][DEM_BODY_REALS + k] : 0;
            else if (touch) b[k] += share*t->gains[q][DEM_BODY_REALS + k];
        }
    }
}

/* Adds the contact of row q, by its share, to the sums of a cell that deforms. */
DEM_INLINE void demi_tile_cell(const dem_world *w, const demi_tile *t, int q, dem_vec3 branch,
                               dem_real share, double *sum) {
    const dem_vec3 f = demi_v(t->force[0][q], t->force[1][q], t->force[2][q]);
    demi_virial_add(sum, f, branch);
    if (!demi_cell_stiffens(w) || !(t->overlap[q] > 0)) return;
    demi_cell_stiffen(w, sum, demi_v(t->normal[0][q], t->normal[1][q], t->normal[2][q]), branch,
                      t->coef[DEMI_KN][q], t->coef[DEMI_K_UN][q], t->coef[DEMI_CN][q],
                      (double)t->overlap[q], (double)share);
}
/* Vector of row q from the centre of body a to that of b, m. */
DEM_INLINE dem_vec3 demi_tile_branch(const demi_tile *t, const demi_span *span, int q) {
    const dem_vec3 gap = demi_rows_at(&t->gap, q);
    return !span->arm ? gap : demi_add(gap, demi_sub(demi_rows_at(&span->arm[0], q),
                                                     demi_rows_at(&span->arm[1], q)));
}
/* Called for every tile when its forces are known. */
typedef void (*demi_tile_fn)(dem_world *w, int d, demi_tile *t, const demi_span *span,
                             const demi_run *r);
/* Adds what the contacts of a tile give to bodies, or to the slots of bodies of later work groups
   (send), to the cell, the ledger and the counts of the work group. note: or null. */
DEM_INLINE void demi_tile_finish(dem_world *w, int d, demi_tile *t, const demi_span *span,
                                 const demi_run *r, int send, demi_tile_fn note) {
    const int full = (span->count + DEMI_LANES - 1)/DEMI_LANES*DEMI_LANES;
    demi_domain *domain = &w->domains[d];
    int q;
    if (r->ledger && w->bodies.booked) demi_tile_late(w, span, full, t);
    if (r->ledger) demi_tile_book(t, span->count, domain->energy);
    demi_tile_tally(t, span->count, r->ranged, domain);
    if (!send) demi_tile_scatter(t, span, r, w->bodies.force, w->bodies.torque);
    else demi_tile_send(t, span, r, w->bodies.force, w->bodies.torque, w->cross_force);
    if (demi_exchanges(w)) demi_tile_rates(t, span, w, send ? w->cross_rate : 0);
    for (q = 0; q < span->count && w->cell.on; q++)
        if (t->touch[q] > 0)
            demi_tile_cell(w, t, q, demi_tile_branch(t, span, q), span->share ? span->share[q] : 1,
                           domain->cell);
    if (note) note(w, d, t, span, r);
}
/* Computes all pairs of a work group: those inside it, then those with later groups. In a world
   with clusters it computes pairs of two lone spheres only; demi_pairs_members computes the
   others. */
DEM_INLINE void demi_pairs_with(dem_world *w, int d, demi_tile_fn note) {
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
            demi_tile_finish(w, d, &tile, &span, demi_tile_respond(w, &span, run, &tile), l, note);
        }
    }
}
static void demi_pairs(dem_world *w, int d) { demi_pairs_with(w, d, 0); }

#if defined(__GNUC__) && !defined(__clang__) && !defined(__TINYC__)
#pragma GCC pop_options
#endif
