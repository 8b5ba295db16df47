/* ---------------------------------------------------------------------------------------------
   >>members
   Contact forces between spheres that may be members of clusters (springs, effects.clustered). The
   pruned neighbour list then holds pairs of member spheres. A lone sphere is the only member of its
   body; pairs of two lone spheres come first in the list, and >>pairs computes them. Of the other
   pairs, a step finds those that touch. These fill tiles of >>points; their histories are in the
   list. Contacts of the same two bodies may be merged (>>persistent). Writes the forces and
   histories of its pairs, their slots, near.on and near.hit (which >>near also uses while it builds
   a list).
   --------------------------------------------------------------------------------------------- */

/* Work of one group: a tile of contacts, which is evaluated when it is full. */
typedef struct demi_member_tile {
    demi_points t;
    int32_t p[DEMI_TILE];          /* entry in the pruned list of its work group */
    unsigned char merged[DEMI_TILE];           /* 1: with others of the same two bodies */
    dem_vec3 felt[2][DEMI_TILE];   /* of these: m, arms for effective masses */
} demi_member_tile;

/* Sets all weights of a tile to 1. */
static void demi_members_clear(demi_member_tile *m) {
    int q;
    for (q = 0; q < DEMI_TILE; q++) {
        m->t.share[q] = m->t.grip[q] = m->t.slope[q] = 1;
        m->t.lift[q] = 0;
        m->t.raised[q] = m->merged[q] = 0;
    }
}
/* Appends entry p of the pruned list to a tile. c: its weights if it is merged with others of the
   same two bodies, or null. */
DEM_INLINE void demi_members_add(const dem_world *w, demi_member_tile *m, int p,
                                 const demi_persistent *c) {
    const int q = m->t.count++;
    m->p[q] = p;
    if (!c) return;
    demi_points_weights(w, &m->t, q, c);
    m->t.weighted = m->merged[q] = 1;
    m->felt[0][q] = demi_sub(c->arm_a, demi_persistent_felt(c));
    m->felt[1][q] = demi_sub(c->arm_b, demi_persistent_felt(c));
}
/* Fills the rows of a tile from its entries and the bodies. Arms lead to the centres of the
   spheres. send: 1 if forces on the bodies b go to slots. */
DEM_INLINE void demi_members_fetch(const dem_world *w, demi_member_tile *DEMI_RESTRICT m, int d,
                                   int full, int send, int following) {
    const size_t base = (size_t)d*(size_t)w->near.stride;
    const int32_t *DEMI_RESTRICT near_a = w->near.a + base;
    const int32_t *DEMI_RESTRICT near_b = w->near.b + base;
    const int32_t *DEMI_RESTRICT ball_a = w->near.ball_a + base;
    const int32_t *DEMI_RESTRICT ball_b = w->near.ball_b + base;
    const int32_t *DEMI_RESTRICT k = w->near.k + base;
    const unsigned char *DEMI_RESTRICT image = w->near.image + base;
    const dem_real *DEMI_RESTRICT ball = w->bodies.ball, *DEMI_RESTRICT arm = w->bodies.centre;
    const dem_real *DEMI_RESTRICT v = w->bodies.vel, *DEMI_RESTRICT u = w->bodies.half_vel;
    const dem_real *DEMI_RESTRICT s = w->bodies.spin, *DEMI_RESTRICT sh = w->bodies.half_spin;
    const dem_real *DEMI_RESTRICT inv = w->bodies.inv_mass, *DEMI_RESTRICT yield = w->bodies.yield;
    demi_points *DEMI_RESTRICT t = &m->t;
    demi_tile *DEMI_RESTRICT rows = &t->rows;
    int n, e;
    for (n = 0; n < full; n++) {
        const size_t q = (size_t)n;
        const int p = m->p[n], a = near_a[p], b = near_b[p], i = ball_a[p], j = ball_b[p];
        const dem_real *x = ball + 4*i, *y = ball + 4*j;
        t->a[n] = a; t->b[n] = b; t->k[n] = send ? k[p] : -1;
        demi_rows_shifted(&rows->gap, q, y, x, w->image_shift + image[p]);
        rows->radius[0][n] = x[3];
        rows->radius[1][n] = y[3];
        demi_rows_minus(&rows->rate, q, v + 4*a, v + 4*b);
        demi_rows_put(&t->arm[0], n, demi_at(arm + 4*i));
        demi_rows_put(&t->arm[1], n, demi_at(arm + 4*j));
        demi_rows_put(&t->spin[0], n, demi_at(s + 4*a));
        demi_rows_put(&t->spin[1], n, demi_at(s + 4*b));
        t->inv[n] = inv[a] + inv[b];
        DEMI_UNROLL
        for (e = 0; e < 6; e++) {
            t->yield[0][e][n] = yield[6*a + e];
            t->yield[1][e][n] = yield[6*b + e];
        }
        if (!following) continue;
        demi_rows_minus(&rows->gone, q, u + 4*a, u + 4*b);
        demi_rows_put(&t->spun[0], n, demi_at(sh + 4*a));
        demi_rows_put(&t->spun[1], n, demi_at(sh + 4*b));
    }
}
/* Copies the histories of a tile's entries. If the weight of friction grows, a spring keeps its
   force, as in demi_persistent_past. */
static void demi_members_recall(const dem_world *w, demi_member_tile *DEMI_RESTRICT m, int d,
                                int full) {
    const int at_grip = w->laws.at_grip, keep = w->memory_stride;
    dem_real *memory = w->near.memory + (size_t)d*(size_t)keep*m->t.hop;
    int e, q;
    for (e = 0; e < keep; e++)
        for (q = 0; q < full; q++)
            m->t.rows.memory[e][q] = memory[(size_t)e*m->t.hop + (size_t)m->p[q]];
    for (q = 0; q < m->t.count && keep; q++) m->t.home[q] = memory + m->p[q];
    if (at_grip == DEMI_MEMORY) return;
    for (q = 0; q < full; q++) {
        const dem_real held = m->t.rows.memory[at_grip][q], now = m->t.grip[q];
        if (m->merged[q] || held > 0) m->t.rows.memory[at_grip][q] = now;   /* 0 until merged */
        if (!(held > 0) || !(now > held) || !demi_laws_keep(w)) continue;
        for (e = 0; e < keep; e++)
            if (w->laws.vectors >> e & 1 || e == w->laws.at_twisting)
                m->t.rows.memory[e][q] *= held/now;
    }
}
/* Copies the coefficients that differ from pair to pair. first: all of them, for a whole tile. */
static void demi_members_coefs(const dem_world *w, demi_member_tile *m, int d, int full,
                               int first) {
    const size_t stride = (size_t)w->near.stride, base = (size_t)d*stride;
    int e, q;
    for (e = 0; e < DEMI_PAIR_COLUMNS; e++) {
        dem_real *to = e == DEMI_M_EFF ? m->t.known
            : e >= DEMI_CN_ROOT ? m->t.root[e - DEMI_CN_ROOT]
            : e == DEMI_KN || e == DEMI_CN || e == DEMI_CT || e >= DEMI_K_UN ? m->t.base[e]
            : m->t.rows.coef[e];
        const dem_real *own = demi_many_species(w) ? w->near.coef +
            (base*DEMI_PAIR_COLUMNS + (size_t)e*stride) : 0;
        const dem_real *table = w->species_coef + e;
        if (!first && !(w->species_vary >> e & 1)) continue;
        for (q = 0; q < full; q++) {
            const size_t at = (size_t)(first ? m->p[0] : m->p[q]);
            to[q] = own ? own[at] : table[w->effects.uniform ? 0
                : DEMI_PAIR_COLUMNS*w->near.row[base + at]];
        }
    }
}
#if defined(__GNUC__) && !defined(__clang__) && !defined(__TINYC__)
#pragma GCC push_options
#pragma GCC optimize("no-trapping-math")
#endif
/* Returns the arm at mid-step of a point of a body, whose arm now is c: with the rotation h of half
   a step it solves mid + h x mid = c. Then the point moves by 2 h x mid in the step. */
DEM_INLINE dem_vec3 demi_arm_mid(dem_vec3 c, dem_vec3 h) {
    const dem_vec3 turned = demi_add(demi_sub(c, demi_cross(h, c)), demi_scale(h, demi_dot(h, c)));
    return demi_scale(turned, 1/(1 + demi_dot(h, h)));
}
/* Finds the contact of row q, and moves the arms from the centres of the spheres to it. */
DEM_INLINE void demi_member_meet(demi_points *DEMI_RESTRICT t, const demi_same *s, int q,
                                 int following, int ranged) {
    demi_tile *rows = &t->rows;
    const dem_vec3 one = demi_rows_at(&t->arm[0], q), other = demi_rows_at(&t->arm[1], q);
    dem_real ra, rb;
    dem_vec3 n, a, b;
    demi_touch_one(rows, s, q, 0, ranged);
    n = demi_row(rows->normal, q);
    ra = rows->length[q]/2 + rows->lean[q];
    rb = rows->length[q]/2 - rows->lean[q];
    a = demi_add(one, demi_scale(n, ra));
    b = demi_sub(other, demi_scale(n, rb));
    demi_rows_put(&t->arm[0], q, a);
    demi_rows_put(&t->arm[1], q, b);
    demi_rows_put(&t->felt[0], q, a);
    demi_rows_put(&t->felt[1], q, b);
    rows->length[q] = rows->lean[q] = 0;
    if (following) {
        const dem_vec3 sa = demi_rows_at(&t->spun[0], q), sb = demi_rows_at(&t->spun[1], q);
        const dem_vec3 ma = demi_arm_mid(one, demi_scale(sa, s->dt/2));
        const dem_vec3 mb = demi_arm_mid(other, demi_scale(sb, s->dt/2));
        const dem_vec3 gone = demi_add(demi_rows_at(&rows->gone, q),
                                       demi_sub(demi_cross(sa, ma), demi_cross(sb, mb)));
        const dem_vec3 way = demi_scale(demi_sub(gone, demi_scale(n, demi_dot(gone, n))),
                                        -(s->dt > 0 ? s->dt : 1)*rows->over_d[q]);
        const dem_vec3 mid = demi_sub(n, demi_scale(way, s->dt > 0 ? DEM_R(0.5) : DEM_R(0)));
        demi_row_put(rows->turn, q, way);
        demi_rows_put(&t->mid[0], q, demi_add(ma, demi_scale(mid, ra)));
        demi_rows_put(&t->mid[1], q, demi_sub(mb, demi_scale(mid, rb)));
    }
}
#define DEMI_MEMBER_STAGE(NAME, FOLLOWING, RANGED) \
    DEMI_CLONES static void NAME(demi_points *DEMI_RESTRICT t, int full) { \
        const demi_same s = t->run.same; \
        DEMI_ROWS(full) demi_member_meet(t, &s, q, FOLLOWING, RANGED); DEMI_ROWS_END \
    }
DEMI_MEMBER_STAGE(demi_members_meet, 0, 0)
DEMI_MEMBER_STAGE(demi_members_meet_following, 1, 0)
DEMI_MEMBER_STAGE(demi_members_meet_ranged, 1, 1)
#undef DEMI_MEMBER_STAGE
#if defined(__GNUC__) && !defined(__clang__) && !defined(__TINYC__)
#pragma GCC pop_options
#endif
/* Evaluates the contacts of a tile. send: 1 if the bodies b are of later work groups. */
static void demi_members_evaluate(const dem_world *w, demi_member_tile *m, int d, int send) {
    const int full = (m->t.count + DEMI_LANES - 1)/DEMI_LANES*DEMI_LANES;
    demi_points *t = &m->t;
    int q, k;
    for (q = t->count; q < full; q++) {         /* the last vector group is padded with copies */
        m->p[q] = m->p[t->count - 1];
        t->grip[q] = 1;
    }
    if (t->run.following) demi_members_fetch(w, m, d, full, send, 1);
    else demi_members_fetch(w, m, d, full, send, 0);
    for (q = 0; q < full && w->cell.on; q++) {
        const dem_vec3 branch = demi_add(demi_rows_at(&t->rows.gap, q),
            demi_sub(demi_rows_at(&t->arm[0], q), demi_rows_at(&t->arm[1], q)));
        demi_rows_flow(w, &t->rows.rate, q, branch);
        if (t->run.following) demi_rows_flow(w, &t->rows.gone, q, branch);
    }
    demi_members_recall(w, m, d, full);
    demi_members_coefs(w, m, d, full, 0);
    (t->run.ranged ? demi_members_meet_ranged : t->run.following ? demi_members_meet_following
        : demi_members_meet)(t, full);
    for (q = 0; q < t->count && t->weighted; q++)
        for (k = 0; k < 2 && m->merged[q]; k++) demi_rows_put(&t->felt[k], q, m->felt[k][q]);
    t->turns = 1;
    demi_points_evaluate(w, t);
}
/* Prepares an empty tile for work group d. dt 0: forces only, history does not advance. */
static void demi_members_begin(const dem_world *w, demi_member_tile *m, int d, dem_real dt) {
    int q;
    demi_points_begin(w, &m->t, dt, DEMI_TILE);
    demi_members_clear(m);
    m->t.hop = (size_t)w->near.stride;
    for (q = 0; q < DEMI_TILE; q++) {
        m->t.contact[q] = 0;
        m->t.couple[q] = 0;
        demi_rows_put(&m->t.outset, q, demi_v(0, 0, 0));
    }
    m->p[0] = demi_near_first(&w->domains[d]);
    demi_members_coefs(w, m, d, DEMI_TILE, 1);
}
/* Evaluates a tile, adds its forces to both bodies and stores its histories. */
static void demi_members_respond(dem_world *w, demi_member_tile *m, int d, int send) {
    const int weighted = m->t.weighted;
    if (!m->t.count) return;
    demi_members_evaluate(w, m, d, send);
    demi_tile_tally(&m->t.rows, m->t.count, m->t.run.ranged, &w->domains[d]);
    demi_points_finish(w, d, &m->t);
    if (weighted) demi_members_clear(m);
}
/* Computes the weights of n contacts of work group d, of pairs of spheres of the same two bodies,
   into w->merging. hit: their entries. Returns them. */
static const demi_persistent *demi_members_merge(const dem_world *w, int d, const int32_t *hit,
                                                 int n) {
    demi_persistent *const first = w->merging + (size_t)d*(size_t)w->merging_most;
    int i;
    for (i = 0; i < n; i++) {
        const size_t at = (size_t)d*(size_t)w->near.stride + (size_t)hit[i];
        const dem_real *x = w->bodies.centre + 4*w->near.ball_a[at];
        const dem_real *y = w->bodies.centre + 4*w->near.ball_b[at];
        demi_persistent *c = first + i;
        demi_persistent_blank(c);
        c->a = w->near.a[at];
        c->b = w->near.b[at];
        c->part_a = w->near.ball_a[at] - w->bodies.centre_start[c->a];
        c->part_b = w->near.ball_b[at] - w->bodies.centre_start[c->b];
        c->share = c->slope = 1;
        demi_balls_meet(w, demi_at(x), x[3], demi_at(y), y[3], demi_near_way(w, at), c);
    }
    demi_persistent_share(w, first, n);
    return first;
}
/* Finds which of entries p .. end - 1 touch or are within the range of the law, and clears the
   history of those that no longer are. Writes them to `hit` and returns their number. */
static int demi_members_touch(dem_world *w, int d, int p, int end, int32_t *hit) {
    const size_t stride = (size_t)w->near.stride, base = (size_t)d*stride;
    const int32_t *DEMI_RESTRICT one = w->near.ball_a + base;
    const int32_t *DEMI_RESTRICT other = w->near.ball_b + base;
    const dem_real *DEMI_RESTRICT ball = w->bodies.ball, *DEMI_RESTRICT shift = w->image_shift;
    const unsigned char *DEMI_RESTRICT image = w->near.image + base;
    unsigned char *DEMI_RESTRICT on = w->near.on + base;
    dem_real *memory = !w->memory_stride ? 0
        : w->near.memory + (size_t)d*(size_t)w->memory_stride*stride;
    const dem_real range = w->margin.reach > 0 ? w->desc.law_range : 0;
    const dem_real more = w->margin.reach > 0 ? 1 + w->desc.law_range_radii : 1;
    int e, n = 0;
    for (; p < end; p++) {
        const dem_real *x = DEMI_AT(ball, one[p]), *y = DEMI_AT(ball, other[p]);
        const dem_real *s = shift + image[p];
        const dem_real dx = y[0] - x[0] + s[0], dy = y[1] - x[1] + s[1], dz = y[2] - x[2] + s[2];
        const dem_real near_by = (x[3] + y[3])*more + range;
        const int now = dx*dx + dy*dy + dz*dz < near_by*near_by;
        hit[n] = p;
        n += now;
        if (on[p] && !now)
            for (e = 0; e < w->memory_stride; e++) memory[(size_t)e*stride + (size_t)p] = 0;
        on[p] = (unsigned char)now;
    }
    return n;
}
/* Computes the pairs of a work group that are not of two lone spheres: first those inside the
   group, then those with later groups. */
static void demi_members_pairs(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    const dem_real dt = w->stage.forces_valid ? w->clock.dt : 0;
    const int merges = w->laws.at_grip < DEMI_MEMORY;
    const int32_t *k = w->near.k + d*w->near.stride;
    int32_t *hit = w->near.hit + d*w->near.stride;
    DEMI_ALIGNED demi_member_tile m;
    int l, p, n, run, i;
    if (domain->near_own <= domain->near_lone[0] &&
        domain->near_end <= domain->near_cross + domain->near_lone[1]) return;
    demi_members_begin(w, &m, d, dt);
    for (l = 0; l < 2; l++) {
        const int begin = (l ? domain->near_cross : 0) + domain->near_lone[l];
        const int end = l ? domain->near_end : domain->near_own;
        for (p = begin; l && p < end; p++)
            if (p == begin || k[p] != k[p - 1]) demi_slot_clear(w, k[p]);
        n = demi_members_touch(w, d, begin, end, hit);
        for (p = 0; p < n; p += run) {
            const demi_persistent *c = 0;
            for (run = 1; merges && p + run < n && k[hit[p + run]] == k[hit[p]];) run++;
            if (run > 1) c = demi_members_merge(w, d, hit + p, run);
            for (i = 0; i < run; i++) {
                demi_members_add(w, &m, hit[p + i], c ? c + i : 0);
                if (m.t.count == DEMI_TILE) demi_members_respond(w, &m, d, l);
            }
        }
        demi_members_respond(w, &m, d, l);
    }
}
/* True if the spheres of entry `at` touch, or are within the range of the law. */
static int demi_member_touches(const dem_world *w, size_t at) {
    const dem_real radii = demi_near_radius(w, at, 0) + demi_near_radius(w, at, 1);
    return demi_length(demi_near_way(w, at)) < radii + demi_range(w, radii);
}
/* As `info` of demi_response_row: computes the force of one pair again, so that nothing changes. */
static int demi_members_info(const dem_world *w, int d, int p, dem_contact_info *out,
                             dem_vec3 *gap) {
    const demi_domain *domain = &w->domains[d];
    const int32_t *k = w->near.k + d*w->near.stride;
    int32_t *hit = w->near.hit + d*w->near.stride;
    const size_t base = (size_t)d*(size_t)w->near.stride;
    const int cross = p >= domain->near_cross;  /* near_cross may be 0 */
    const int from = cross ? domain->near_cross : 0;
    const int end = cross ? domain->near_end : domain->near_own;
    const demi_persistent *c = 0;
    DEMI_ALIGNED demi_member_tile m;
    int i, n = 0, at = 0;
    if (!demi_member_touches(w, base + (size_t)p)) return 0;
    if (!out) return 1;
    for (i = p; i > from && k[i - 1] == k[p];) i--;
    for (; i < end && k[i] == k[p] && w->laws.at_grip < DEMI_MEMORY; i++) {
        if (i == p) at = n;
        if (demi_member_touches(w, base + (size_t)i)) hit[n++] = i;
    }
    if (n > 1) c = demi_members_merge(w, d, hit, n);
    demi_balls_place(w, w->near.a[base + (size_t)p], w->near.a[base + (size_t)p] + 1);
    demi_balls_place(w, w->near.b[base + (size_t)p], w->near.b[base + (size_t)p] + 1);
    demi_members_begin(w, &m, d, 0);
    demi_members_add(w, &m, p, c ? c + at : 0);
    demi_members_evaluate(w, &m, d, 0);
    out->normal = demi_row(m.t.rows.normal, 0);
    out->overlap = m.t.rows.overlap[0];
    out->force = demi_row(m.t.rows.force, 0);
    *gap = demi_rows_at(&m.t.rows.gap, 0);
    return 1;
}
