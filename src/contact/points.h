/* ---------------------------------------------------------------------------------------------
   >>points
   Forces of contacts at points of bodies: of member spheres (>>members) and persistent contacts
   (>>persistent-respond), with bodies and walls, a tile at a time. Those two fill the tile: who
   touches, the arms from both centres to the contact, the relative motion of the centres,
   coefficients, weights and history. A wall is a body b with zero arm: velocities are relative to
   its surface at the contact. This part computes effective masses and the motion at the contact,
   evaluates the laws by the stages of >>respond, and multiplies by the weights. Owns no data.
   --------------------------------------------------------------------------------------------- */
#if defined(__GNUC__) && !defined(__clang__) && !defined(__TINYC__)
#pragma GCC push_options
#pragma GCC optimize("no-trapping-math")
#endif
/* Returns (c x n).W (c x n), 1/kg, with the arm c and inverse inertia W of one side of row q. */
DEM_INLINE dem_real demi_point_give(const demi_points *t, int side, dem_vec3 n, int q) {
    const dem_vec3 v = demi_cross(demi_rows_at(&t->felt[side], q), n);
    return t->yield[side][0][q]*v.x*v.x + t->yield[side][1][q]*v.y*v.y +
        t->yield[side][2][q]*v.z*v.z + 2*(t->yield[side][3][q]*v.x*v.y +
        t->yield[side][4][q]*v.x*v.z + t->yield[side][5][q]*v.y*v.z);
}
/* Effective mass m* of a contact, kg: from both bodies at the ends of `felt`, unless known. */
DEM_INLINE void demi_point_mass(demi_points *DEMI_RESTRICT t, int q) {
    const dem_vec3 n = demi_row(t->rows.normal, q);
    const dem_real known = t->known[q];
    const dem_real m = 1/(t->inv[q] + demi_point_give(t, 0, n, q) + demi_point_give(t, 1, n, q) +
                          DEMI_TINY);
    t->rows.coef[DEMI_M_EFF][q] = known > 0 ? known : m;
}
/* Relative motion at the contact: now, and (following) averaged over the step just taken. On entry
   `turn` is the change of the normal in this step, on return its rate, 1/s; without a step (dt 0)
   it is the rate already. */
DEM_INLINE void demi_point_motion(demi_points *DEMI_RESTRICT t, const demi_same *s, int q,
                                  int following) {
    const dem_vec3 n = demi_row(t->rows.normal, q);
    const dem_vec3 wa = demi_rows_at(&t->spin[0], q), wb = demi_rows_at(&t->spin[1], q);
    const dem_vec3 apart = demi_sub(wa, wb);
    const dem_vec3 u = demi_sub(demi_add(demi_rows_at(&t->rows.rate, q),
                                         demi_cross(wa, demi_rows_at(&t->arm[0], q))),
                                demi_cross(wb, demi_rows_at(&t->arm[1], q)));
    const dem_real closing = demi_dot(u, n), slope = t->slope[q];
    const dem_real root = DEMI_SQRT(t->rows.coef[DEMI_M_EFF][q]);
    int e;
    demi_row_put(t->rows.slip, q, demi_sub(u, demi_scale(n, closing)));
    demi_rows_put(&t->rows.apart, q, apart);
    t->rows.coef[DEMI_KN][q] = t->base[DEMI_KN][q]*slope;
    t->rows.coef[DEMI_CN][q] = t->base[DEMI_CN][q]*slope + slope*t->root[0][q]*root;
    t->rows.coef[DEMI_CT][q] = t->base[DEMI_CT][q] + t->root[1][q]*root;
    DEMI_UNROLL
    for (e = DEMI_K_UN; e < DEMI_COEFS; e++) t->rows.coef[e][q] = t->base[e][q]*slope;
    /* the moment about the normal also does work */
    t->rows.closing[q] = closing + t->couple[q]*demi_dot(apart, n);
    if (following) {
        const dem_real per = s->dt > 0 ? 1/s->dt : 1, half = s->dt > 0 ? DEM_R(0.5) : DEM_R(0);
        const dem_vec3 way = demi_row(t->rows.turn, q);
        const dem_vec3 mid = demi_sub(n, demi_scale(way, half));
        const dem_vec3 sa = demi_rows_at(&t->spun[0], q), sb = demi_rows_at(&t->spun[1], q);
        const dem_vec3 turn = demi_scale(way, per);
        dem_vec3 gone = demi_sub(demi_add(demi_rows_at(&t->rows.gone, q),
                                          demi_cross(sa, demi_rows_at(&t->mid[0], q))),
                                 demi_cross(sb, demi_rows_at(&t->mid[1], q)));
        gone = demi_sub(gone, demi_scale(mid, demi_dot(gone, mid)));
        demi_row_put(t->rows.slip_step, q, demi_sub(gone, demi_scale(n, demi_dot(gone, n))));
        demi_row_put(t->rows.turn, q, demi_sub(turn, demi_scale(n, demi_dot(turn, n))));
        demi_rows_put(&t->rows.parted, q, demi_sub(sa, sb));
        t->rows.twist[q] = demi_dot(demi_add(sa, sb), n)/2;
    }
}
/* Multiplies forces, moments and energies by their weights. The elastic energy is
   V = k overlap^2/2, while the law was given k slope. */
DEM_INLINE void demi_point_weigh(demi_points *DEMI_RESTRICT t, int q, int ledger) {
    demi_tile *rows = &t->rows;
    const dem_real share = t->share[q], grip = t->grip[q], stored = share/t->slope[q];
    rows->repulsion[q] = share*rows->repulsion[q] + t->lift[q]*t->still[q];
    demi_row_put(rows->tangent, q, demi_scale(demi_row(rows->tangent, q), grip));
    demi_row_put(rows->moment, q, demi_scale(demi_row(rows->moment, q), grip));
    if (!ledger) return;
    rows->part[0][q] *= share;
    rows->part[1][q] *= stored; rows->part[6][q] *= stored;
    rows->part[2][q] *= grip; rows->part[3][q] *= grip;
    rows->part[4][q] *= grip; rows->part[5][q] *= grip;
}
/* Torques on both bodies about their centres, of the force and the moments of row q; `moment`
   receives the latter. turning: are there any from the laws? weighted: is the normal force not at
   the contact, or with a moment about it? */
DEM_INLINE void demi_point_torques(demi_points *DEMI_RESTRICT t, int q, int turning, int weighted) {
    demi_tile *rows = &t->rows;
    const dem_vec3 f = demi_row(rows->force, q);
    const dem_vec3 push = demi_scale(demi_row(rows->normal, q), rows->repulsion[q]);
    dem_vec3 m = turning ? demi_row(rows->torque[0], q) : demi_v(0, 0, 0);
    dem_vec3 a = demi_cross(demi_rows_at(&t->arm[0], q), f);
    if (weighted) {
        m = demi_sub(m, demi_scale(push, t->couple[q]));
        a = demi_add(a, demi_cross(demi_rows_at(&t->outset, q), push));
    }
    demi_row_put(rows->moment, q, m);
    demi_row_put(rows->torque[0], q, demi_add(a, m));
    demi_row_put(rows->torque[1], q,
                 demi_scale(demi_add(demi_cross(demi_rows_at(&t->arm[1], q), f), m), -1));
}
#define DEMI_POINT_STAGE(NAME, ONE) \
    DEMI_CLONES static void NAME(demi_points *DEMI_RESTRICT t, int full) { \
        const demi_same s = t->run.same; \
        (void)s; \
        DEMI_ROWS(full) ONE; DEMI_ROWS_END \
    }
DEMI_POINT_STAGE(demi_points_mass, demi_point_mass(t, q))
DEMI_POINT_STAGE(demi_points_motion, demi_point_motion(t, &s, q, 0))
DEMI_POINT_STAGE(demi_points_motion_following, demi_point_motion(t, &s, q, 1))
DEMI_POINT_STAGE(demi_points_weigh, demi_point_weigh(t, q, 0))
DEMI_POINT_STAGE(demi_points_weigh_ledger, demi_point_weigh(t, q, 1))
DEMI_POINT_STAGE(demi_points_torques_bare, demi_point_torques(t, q, 0, 0))
DEMI_POINT_STAGE(demi_points_torques, demi_point_torques(t, q, 1, 0))
DEMI_POINT_STAGE(demi_points_torques_weighted, demi_point_torques(t, q, 1, 1))
#undef DEMI_POINT_STAGE
#if defined(__GNUC__) && !defined(__clang__) && !defined(__TINYC__)
#pragma GCC pop_options
#endif

/* True if two weights differ. */
DEM_INLINE int demi_differ(dem_real a, dem_real b) { return a < b || a > b; }
/* Sets the weights of row q to those of contact c (demi_persistent). */
DEM_INLINE void demi_points_weights(const dem_world *w, demi_points *t, int q,
                                    const demi_persistent *c) {
    t->share[q] = c->share;
    t->grip[q] = c->grip;
    t->slope[q] = c->slope;
    t->lift[q] = c->lift - c->share;
    t->raised[q] = (unsigned char)demi_differ(c->lift, c->share);
    t->weighted |= c->odd || t->raised[q] || demi_differ(c->share, 1) || demi_differ(c->grip, 1) ||
        (w->desc.ledger && demi_differ(c->slope, 1));
    if (c->odd && demi_dot(c->more.aside, c->more.aside) > 0) {
        /* on a at the centre of its sphere, on b at the point that the normal rotates about */
        const dem_vec3 centre = demi_part_now(w, c->a, c->part_a).centre;
        const dem_real turn = c->bend < 0 || c->bend > 0 ? c->bend : c->more.along;
        t->aside[q] = c->more.aside;
        t->side[0][q] = centre;
        t->side[1][q] = demi_add(c->arm_b, demi_sub(demi_sub(centre, c->arm_a),
                                                    demi_scale(c->normal, 1/turn)));
        t->raised[q] = 2;
    }
    t->lifted |= t->raised[q];
}
/* Prepares an empty tile whose first `rows` rows will be used. dt 0: forces only, history does not
   advance. */
static void demi_points_begin(const dem_world *w, demi_points *t, dem_real dt, int rows) {
    int q;
    t->run = demi_run_of(w, dt, 0);
    t->laws = demi_run_begin(w, dt);
    if (!w->desc.law) demi_run_laws(w, &t->laws, 0);
    memset(&t->span, 0, sizeof t->span);
    t->span.a = t->a;
    t->span.b = t->b;
    t->span.k = t->k;
    t->span.points = t;
    t->run.span = t->laws.span = &t->span;
    t->count = t->ready = t->turns = t->weighted = t->lifted = 0;
    for (q = 0; q < DEMI_TILE && q < rows; q++) {
        t->rows.touch[q] = 1;
        t->rows.length[q] = t->rows.lean[q] = 0;        /* no arms: stages return moments alone */
        t->rows.memory[DEMI_MEMORY][q] = t->rows.repulsion[q] = 0;
        t->filled[q] = 0;
        t->still[q] = 0;                        /* if none is lifted */
        demi_row_put(t->rows.tangent, q, demi_v(0, 0, 0));      /* if no law sets it */
        demi_row_put(t->rows.moment, q, demi_v(0, 0, 0));
        t->rows.slope[0][q] = t->rows.slope[1][q] = t->rows.kt[1][q] = (dem_real)NAN;
    }
    if (t->run.ledger) memset(t->rows.part, 0, sizeof t->rows.part);
}
/* Calls the user-defined law for each contact of a tile, first at rest for those lifted. */
static void demi_points_law(const dem_world *w, demi_points *t) {
    const demi_same same = t->run.same;
    dem_contact c;
    int q, rests;
    demi_who_clear(&c.who);
    for (q = 0; q < t->count; q++)
        for (t->still[q] = 0, rests = t->raised[q] > 0; rests >= 0; rests--) {
            dem_real *still = rests ? &t->still[q] : 0, m[DEMI_MEMORY];
            dem_contact_force f;
            demi_tile_own(&t->rows, &t->run, &same, q, w->desc.law_who, &c);
            if (still) c.closing_speed = 0;
            demi_recall(&t->rows, q, 0, t->run.keep, m);
            demi_law(w, &c, m, &f);
            if (still) { *still = f.normal; continue; }
            demi_keep(&t->rows, q, 0, t->run.keep, m);
            demi_normal_put(&t->rows, &same, q, &f, 2);
            demi_tangent_put(&t->rows, &same, q, &f, 2);
            if (same.at_sliding == DEMI_MEMORY) t->rows.memory[DEMI_MEMORY][q] = 0;    /* of none */
            demi_rolling_put(&t->rows, &same, q, &f, 2);
        }
}
/* Evaluates the normal law at zero closing speed: the elastic force alone, N. History is
   restored. */
static void demi_points_still(demi_points *t, int full) {
    const demi_run *r = &t->laws;
    const int at = r->same.at_normal;
    dem_real closing[DEMI_TILE], memory[DEMI_MEMORY][DEMI_TILE];
    int e, q;
    for (q = 0; q < full; q++) {
        closing[q] = t->rows.closing[q];
        t->rows.closing[q] = 0;
        for (e = at; e < r->keep; e++) memory[e][q] = t->rows.memory[e][q];
    }
    r->stage[0](&t->rows, r, full);
    for (q = 0; q < full; q++) {
        t->still[q] = t->rows.repulsion[q];
        t->rows.closing[q] = closing[q];
        for (e = at; e < r->keep; e++) t->rows.memory[e][q] = memory[e][q];
    }
}
/* Adds the elastic force across the normal that merged contacts have. */
static void demi_points_aside(demi_points *t) {
    int q;
    for (q = 0; q < t->count; q++) {
        dem_vec3 aside, far;
        if (t->raised[q] < 2) continue;
        aside = demi_scale(t->aside[q], t->still[q]);
        far = demi_sub(t->side[1][q], demi_rows_at(&t->arm[1], q));
        demi_row_put(t->rows.force, q, demi_add(demi_row(t->rows.force, q), aside));
        demi_row_put(t->rows.moment, q, demi_add(demi_row(t->rows.moment, q),
                                                 demi_cross(far, aside)));
        demi_row_put(t->rows.torque[0], q, demi_add(demi_row(t->rows.torque[0], q),
                                                    demi_cross(t->side[0][q], aside)));
        demi_row_put(t->rows.torque[1], q, demi_sub(demi_row(t->rows.torque[1], q),
                                                    demi_cross(t->side[1][q], aside)));
    }
}
/* Evaluates the contacts of a tile: forces, and torques about the centres of the bodies. */
static void demi_points_evaluate(const dem_world *w, demi_points *t) {
    const int full = (t->count + DEMI_LANES - 1)/DEMI_LANES*DEMI_LANES;
    const demi_run *r = &t->run;
    demi_tile *rows = &t->rows;
    int k;
    t->span.count = t->count;
    if (t->turns) demi_points_mass(t, full);
    (r->following ? demi_points_motion_following : demi_points_motion)(t, full);
    if (!t->weighted) {
        for (k = 1; k < DEMI_STAGES && r->stage[k]; k++) r->stage[k](rows, r, full);
        (r->turning ? demi_points_torques : demi_points_torques_bare)(t, full);
        return;
    }
    if (w->desc.law) demi_points_law(w, t);
    else {
        if (t->lifted) demi_points_still(t, full);
        for (k = 0; k < DEMI_STAGES && t->laws.stage[k]; k++)
            t->laws.stage[k](rows, &t->laws, full);
    }
    (r->ledger ? demi_points_weigh_ledger : demi_points_weigh)(t, full);
    if (!r->turning) memset(rows->torque[0], 0, sizeof rows->torque[0]);
    demi_answer_choose(r, demi_laws_roll(w))(rows, r, full);
    demi_points_torques_weighted(t, full);
    if (t->lifted) demi_points_aside(t);
}
/* Adds what the contacts of an evaluated tile give, stores their histories, and empties it. */
static void demi_points_finish(dem_world *w, int d, demi_points *t) {
    int q, e;
    for (q = 0; q < t->count; q++)
        for (e = 0; e < t->run.keep; e++) {
            DEMI_ONE_BY_ONE(e);                 /* no call of memcpy for so few */
            t->home[q][(size_t)e*t->hop] = t->rows.memory[e][q];
        }
    demi_tile_finish(w, d, &t->rows, &t->span, &t->run, 0);
    t->count = t->turns = t->weighted = t->lifted = 0;
}
