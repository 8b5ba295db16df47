/* ---------------------------------------------------------------------------------------------
   >>choose
   Which stages a scene needs: user-defined laws as stages, and the choice of stages for the laws in
   force. A scene runs only these, so any combination of laws costs the sum of its parts.
   --------------------------------------------------------------------------------------------- */

/* Fills in `who` for a law that has desc.law_who set, for bodies a and b with radii ra and rb, m;
   b < 0: wall -1 - b, which has no rb. arm: m, from a's centre to the contact point. */
static void demi_who_fill(const dem_world *w, int a, int b, dem_real ra, dem_real rb, dem_vec3 arm,
                          dem_real *rates, dem_contact_who *who) {
    const demi_periods periods = demi_periods_of(w);
    demi_who_clear(who);
    who->a = dem_body_id_get(w, a);
    who->radius_a = ra;
    who->mass_a = w->bodies.mass[a];
    who->radius_b = b >= 0 ? rb
        : demi_wall_is(&w->walls[-1 - b], DEMI_BALLS) ? w->walls[-1 - b].radius : 0;
    if (b >= 0) who->b = dem_body_id_get(w, b);
    if (b >= 0) who->mass_b = w->bodies.mass[b];
    who->point = demi_place_of(&periods, demi_add(demi_at(w->bodies.pos + 4*a), arm));
    who->time = w->clock.time;
    demi_who_reals(w, a, DEMI_MAX(b, -1), b < 0 ? -1 - b : 0, rates, who);
}
/* The same for row q. */
static DEMI_APART void demi_tile_who(const demi_tile *t, const demi_run *r, int q,
                                     dem_real *rates, dem_contact *c) {
    const dem_real ra = t->radius[0][q], rb = t->radius[1][q];
    demi_who_fill(r->w, r->span->a[q], r->span->b[q], ra, rb,
                  r->span->points ? demi_rows_at(&r->span->points->arm[0], q)
                  : demi_scale(demi_rows_at(&t->gap, q), ra/(ra + rb)), rates, &c->who);
}
/* Material of side b of row q: 1 + index. */
DEM_INLINE int32_t demi_span_material(const dem_world *w, const demi_span *span, int q) {
    const int b = span->b[q];
    return b >= 0 ? w->bodies.material[b] : w->walls[-1 - b].material + 1;
}
/* Fills a dem_contact from row q for a user-defined law. */
DEM_INLINE void demi_tile_own(demi_tile *DEMI_RESTRICT t, const demi_run *r, const demi_same *same,
                              int q, int who, dem_contact *c) {
    const dem_world *w = r->w;
    demi_tile_contact(t, same, q, c);
    c->range = r->ranged ? demi_tile_range(t, same, q, 0) : 0;
    c->material_a = w->bodies.material[r->span->a[q]];
    c->material_b = demi_span_material(w, r->span, q);
    if (r->span->b[q] < 0) c->wall = w->walls[-1 - r->span->b[q]].id;
    c->user = w->desc.law_user;
    if (who) demi_tile_who(t, r, q, t->gains[q], c);
}
/* Calls the user-defined law for row q. */
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
/* Calls a user-defined law row by row, and only for those in contact or within its range. */
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
/* Passes the columns of a tile to the law. Those that stages store otherwise are copied first. */
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
        material[1][e] = demi_span_material(w, r->span, e);
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
/* How the stages evaluate the laws, in reports. */
static const char *demi_stages_name(const dem_world *w) {
    if (w->desc.law) return demi_own_rows(w) ? "your law, row by row" : "your law, called";
    return demi_whole_stage(w, w->effects.uniform) ? "all laws at once" : "law by law";
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
/* Returns the run for contacts of spheres. alike: for pairs of identical bodies; it gives the same
   bits as the general one. >>points uses all but the first stage of the general one. */
static demi_run demi_run_of(const dem_world *w, dem_real dt, int alike) {
    const demi_stage whole = demi_whole_stage(w, alike);
    demi_run r = demi_run_begin(w, dt);
    int k = 0;
    r.alike = alike;
    r.parting |= r.turning && !alike;
    r.same.radius = w->effects.species[0].radius;
    r.same.inv_radius = r.same.radius > 0 ? 1/r.same.radius : 0;
    r.stage[k++] = r.ranged ? demi_stage_mixed_ranged
        : r.following ? r.alike ? demi_stage_alike_following : demi_stage_mixed_following
        : r.turning ? r.alike ? demi_stage_alike_turning : demi_stage_mixed_turning
        : r.alike ? demi_stage_alike_bare : demi_stage_mixed_bare;
    if (whole) { r.stage[k] = whole; return r; }
    k = demi_run_laws(w, &r, k);
    r.stage[k] = demi_answer_choose(&r, demi_laws_roll(w));
    return r;
}
