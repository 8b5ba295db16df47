/* ---------------------------------------------------------------------------------------------
   >>members
   Contact forces between spheres that may be members of clusters (springs, effects.clustered). The
   pruned neighbour list then holds pairs of member spheres. A lone sphere is the only member of its
   body; pairs of two lone spheres come first in the list, and >>pairs computes them. Of the other
   pairs, a step finds those that touch. These fill a tile with the relative motion of the two
   spheres, which are points of their bodies, and the stages of >>respond evaluate the laws as for
   lone spheres. Clusters differ in three ways: the effective mass at a contact depends on the
   orientations of the bodies, contacts of the same two bodies may be merged (>>kept), and a force
   acts at the centre of a member sphere. Writes the forces and contact histories of its pairs,
   their slots, near.on and near.hit (which >>near also uses while it builds a list).
   --------------------------------------------------------------------------------------------- */

/* Work of one group: a tile of contacts, which is evaluated when it is full. */
typedef struct demi_member_tile {
    demi_kept_tile t;              /* of these: rows, arm, spin, spun, share, grip, lift, still */
    int32_t a[DEMI_TILE], b[DEMI_TILE], k[DEMI_TILE];      /* bodies; candidate */
    int32_t p[DEMI_TILE];          /* entry in the pruned list of its work group */
    int32_t ball[2][DEMI_TILE];    /* spheres */
    dem_real inv[DEMI_ROOM], yield[2][6][DEMI_ROOM];       /* 1/kg, of both; as in demi_bodies */
    demi_rows felt[2];             /* m, if any is merged: arms for effective masses */
    dem_real base[5][DEMI_ROOM];   /* cn and ct without m*; their parts by root m*; m*, or 0 */
    int merged[DEMI_TILE];         /* 1: with others of the same two bodies */
    dem_vec3 at[2][DEMI_TILE], aside[DEMI_TILE];           /* of these: felt; see demi_kept_more */
    demi_span span;                /* a, b and k, for stages that name bodies */
    demi_run run, laws;            /* all stages; those of the laws only */
    int count, weighted;           /* contacts; are any merged? */
} demi_member_tile;

/* Empties a tile and sets all its weights to 1. */
static void demi_member_clear(demi_member_tile *m) {
    int q;
    m->count = m->weighted = 0;
    for (q = 0; q < DEMI_TILE; q++) {
        m->t.share[q] = m->t.grip[q] = 1;
        m->t.lift[q] = 0;
        m->merged[q] = 0;
    }
}
/* Appends entry p of the pruned list to a tile. c: its weights if it is merged with others of the
   same two bodies, or null. */
DEM_INLINE void demi_member_add(demi_member_tile *m, int p, const demi_kept *c) {
    const int q = m->count++;
    m->p[q] = p;
    if (!c) return;
    m->t.share[q] = c->share;
    m->t.grip[q] = c->grip;
    m->t.lift[q] = c->lift - c->share;
    m->merged[q] = 1;
    m->at[0][q] = demi_sub(c->arm_a, demi_kept_felt(c));
    m->at[1][q] = demi_sub(c->arm_b, demi_kept_felt(c));
    m->aside[q] = c->odd ? c->more.aside : demi_v(0, 0, 0);
    m->weighted = 1;
}
/* Fills the rows of a tile from its entries and the bodies. */
DEM_INLINE void demi_member_fetch(const dem_world *w, demi_member_tile *DEMI_RESTRICT m,
                                  size_t base, int full, int following) {
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
    demi_tile *DEMI_RESTRICT rows = &m->t.rows;
    int n, e;
    for (n = 0; n < full; n++) {
        const size_t q = (size_t)n;
        const int p = m->p[n], a = near_a[p], b = near_b[p], i = ball_a[p], j = ball_b[p];
        const dem_real *x = ball + 4*i, *y = ball + 4*j;
        m->a[n] = a; m->b[n] = b; m->k[n] = k[p];
        m->ball[0][n] = i; m->ball[1][n] = j;
        demi_rows_shifted(&rows->gap, q, y, x, w->image_shift + image[p]);
        rows->radius[0][n] = x[3];
        rows->radius[1][n] = y[3];
        demi_rows_minus(&rows->rate, q, v + 4*a, v + 4*b);
        demi_rows_put(&m->t.arm[0], n, demi_at(arm + 4*i));
        demi_rows_put(&m->t.arm[1], n, demi_at(arm + 4*j));
        demi_rows_put(&m->t.spin[0], n, demi_at(s + 4*a));
        demi_rows_put(&m->t.spin[1], n, demi_at(s + 4*b));
        m->inv[n] = inv[a] + inv[b];
        DEMI_UNROLL
        for (e = 0; e < 6; e++) {
            m->yield[0][e][n] = yield[6*a + e];
            m->yield[1][e][n] = yield[6*b + e];
        }
        if (!following) continue;
        demi_rows_minus(&rows->gone, q, u + 4*a, u + 4*b);
        demi_rows_put(&m->t.spun[0], n, demi_at(sh + 4*a));
        demi_rows_put(&m->t.spun[1], n, demi_at(sh + 4*b));
    }
}
/* Copies the histories of a tile's entries. If the weight of friction grows, a spring keeps its
   force, as in demi_kept_past. */
static void demi_member_recall(const dem_world *w, demi_member_tile *DEMI_RESTRICT m, int d,
                               int full) {
    const size_t stride = (size_t)w->near.stride;
    const int at_grip = w->laws.at_grip, keep = w->memory_stride;
    int e, q;
    for (e = 0; e < keep; e++) {
        const dem_real *DEMI_RESTRICT memory = w->near.memory +
            ((size_t)d*(size_t)keep + (size_t)e)*stride;
        for (q = 0; q < full; q++) m->t.rows.memory[e][q] = memory[m->p[q]];
    }
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
static void demi_member_coefs(const dem_world *w, demi_member_tile *m, int d, int full, int first) {
    const size_t stride = (size_t)w->near.stride, base = (size_t)d*stride;
    int e, q;
    for (e = 0; e < DEMI_PAIR_COLUMNS; e++) {
        dem_real *to = e == DEMI_CN ? m->base[0] : e == DEMI_CT ? m->base[1]
            : e == DEMI_CN_ROOT ? m->base[2] : e == DEMI_CT_ROOT ? m->base[3]
            : e == DEMI_M_EFF ? m->base[4] : m->t.rows.coef[e];
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
/* Turns the relative motion of two bodies into that of the centres of two of their spheres, and
   sets sums and differences of spins. */
DEM_INLINE void demi_member_swing_one(demi_member_tile *DEMI_RESTRICT m, dem_real half, int q,
                                      int following) {
    demi_tile *rows = &m->t.rows;
    const dem_vec3 one = demi_rows_at(&m->t.arm[0], q), other = demi_rows_at(&m->t.arm[1], q);
    const dem_vec3 wa = demi_rows_at(&m->t.spin[0], q), wb = demi_rows_at(&m->t.spin[1], q);
    demi_rows_put(&rows->rate, q, demi_add(demi_rows_at(&rows->rate, q),
                                           demi_sub(demi_cross(wa, one), demi_cross(wb, other))));
    demi_rows_put(&rows->around, q, demi_add(wa, wb));
    demi_rows_put(&rows->apart, q, demi_sub(wa, wb));
    if (following) {
        const dem_vec3 sa = demi_rows_at(&m->t.spun[0], q), sb = demi_rows_at(&m->t.spun[1], q);
        const dem_vec3 ma = demi_arm_mid(one, demi_scale(sa, half));
        const dem_vec3 mb = demi_arm_mid(other, demi_scale(sb, half));
        demi_rows_put(&rows->gone, q, demi_add(demi_rows_at(&rows->gone, q),
                                               demi_sub(demi_cross(sa, ma), demi_cross(sb, mb))));
        demi_rows_put(&rows->turned, q, demi_add(sa, sb));
        demi_rows_put(&rows->parted, q, demi_sub(sa, sb));
    }
}
DEMI_CLONES static void demi_member_swing(demi_member_tile *DEMI_RESTRICT m, dem_real half,
                                          int full) {
    DEMI_ROWS(full) demi_member_swing_one(m, half, q, 0); DEMI_ROWS_END
}
DEMI_CLONES static void demi_member_swing_following(demi_member_tile *DEMI_RESTRICT m,
                                                    dem_real half, int full) {
    DEMI_ROWS(full) demi_member_swing_one(m, half, q, 1); DEMI_ROWS_END
}
/* Returns (c x n).W (c x n), 1/kg, with arm c, the normal n of row q and inverse inertia W. */
DEM_INLINE dem_real demi_member_give(dem_vec3 c, dem_vec3 n, dem_real W[6][DEMI_ROOM], int q) {
    const dem_vec3 v = demi_cross(c, n);
    return W[0][q]*v.x*v.x + W[1][q]*v.y*v.y + W[2][q]*v.z*v.z +
        2*(W[3][q]*v.x*v.y + W[4][q]*v.x*v.z + W[5][q]*v.y*v.z);
}
/* Effective mass at each contact, kg, unless known, and the part of the damping that depends on
   it. felt: m, arms of both sides. */
DEMI_CLONES static void demi_member_mass(demi_member_tile *DEMI_RESTRICT m, const demi_rows *felt,
                                         int full) {
    DEMI_ROWS(full)
        const dem_vec3 n = demi_row(m->t.rows.normal, q);
        const dem_real give = m->inv[q] +
            demi_member_give(demi_rows_at(&felt[0], q), n, m->yield[0], q) +
            demi_member_give(demi_rows_at(&felt[1], q), n, m->yield[1], q);
        const dem_real known = m->base[4][q], mass = known > 0 ? known : 1/(give + DEMI_TINY);
        const dem_real root = DEMI_SQRT(mass);
        m->t.rows.coef[DEMI_M_EFF][q] = mass;
        m->t.rows.coef[DEMI_CN][q] = m->base[0][q] + m->base[2][q]*root;
        m->t.rows.coef[DEMI_CT][q] = m->base[1][q] + m->base[3][q]*root;
    DEMI_ROWS_END
}
/* Multiplies forces, moments and energies by their weights, see demi_kept_book. */
DEMI_CLONES static void demi_member_weigh(demi_kept_tile *DEMI_RESTRICT t, int full) {
    demi_tile *rows = &t->rows;
    DEMI_ROWS(full)
        const dem_real share = t->share[q], grip = t->grip[q];
        rows->repulsion[q] = share*rows->repulsion[q] + t->lift[q]*t->still[q];
        demi_row_put(rows->tangent, q, demi_scale(demi_row(rows->tangent, q), grip));
        demi_row_put(rows->moment, q, demi_scale(demi_row(rows->moment, q), grip));
        rows->part[0][q] *= share; rows->part[1][q] *= share; rows->part[6][q] *= share;
        rows->part[2][q] *= grip; rows->part[3][q] *= grip;
        rows->part[4][q] *= grip; rows->part[5][q] *= grip;
    DEMI_ROWS_END
}
#if defined(__GNUC__) && !defined(__clang__) && !defined(__TINYC__)
#pragma GCC pop_options
#endif
/* Calls the user-defined law for each contact of a tile, first at rest for merged contacts. */
static void demi_member_law(const dem_world *w, demi_member_tile *m) {
    const demi_same same = m->run.same;
    dem_contact c;
    int q, rests;
    demi_who_clear(&c.who);
    for (q = 0; q < m->count; q++)
        for (rests = m->merged[q]; rests >= 0; rests--) {
            demi_tile_own(&m->t.rows, &m->run, &same, q, w->desc.law_who, &c);
            demi_row_law(w, &m->t.rows, &m->run, q, &c, rests ? &m->t.still[q] : 0);
        }
}
/* Evaluates the contacts of a tile: forces and torques about the centres of the spheres. */
static void demi_member_evaluate(const dem_world *w, demi_member_tile *m, int d) {
    const int full = (m->count + DEMI_LANES - 1)/DEMI_LANES*DEMI_LANES;
    const size_t base = (size_t)d*(size_t)w->near.stride;
    demi_run *r = &m->run;
    demi_tile *rows = &m->t.rows;
    int k, q;
    m->span.count = m->count;
    r->span = &m->span;
    for (q = m->count; q < full; q++) {         /* the last vector group is padded with copies */
        m->p[q] = m->p[m->count - 1];
        m->t.grip[q] = 1;
    }
    if (r->following) demi_member_fetch(w, m, base, full, 1);
    else demi_member_fetch(w, m, base, full, 0);
    for (q = 0; q < full && w->cell.on; q++) {
        const dem_vec3 branch = demi_tile_branch(rows, &m->span, q);
        demi_rows_flow(w, &rows->rate, q, branch);
        if (r->following) demi_rows_flow(w, &rows->gone, q, branch);
    }
    demi_member_recall(w, m, d, full);
    demi_member_coefs(w, m, d, full, 0);
    for (q = 0; q < full && m->weighted; q++)
        for (k = 0; k < 2; k++)
            demi_rows_put(&m->felt[k], q, q < m->count && m->merged[q] ? m->at[k][q]
                          : demi_rows_at(&m->t.arm[k], q));
    (r->following ? demi_member_swing_following : demi_member_swing)(m, r->same.dt/2, full);
    r->stage[0](rows, r, full);                 /* contact detection and relative motion */
    demi_member_mass(m, m->weighted ? m->felt : m->t.arm, full);
    if (!m->weighted) {
        for (k = 1; k < DEMI_STAGES && r->stage[k]; k++) r->stage[k](rows, r, full);
        return;
    }
    for (q = 0; q < full; q++) m->t.still[q] = 0;
    if (w->desc.law) demi_member_law(w, m);
    else {
        demi_kept_still(&m->t, &m->laws, full);
        for (k = 0; k < DEMI_STAGES && m->laws.stage[k]; k++)
            m->laws.stage[k](rows, &m->laws, full);
    }
    demi_member_weigh(&m->t, full);
    demi_answer_choose(r, demi_laws_roll(w))(rows, r, full);
    for (q = 0; q < m->count; q++)              /* at the centre of the sphere: no torque */
        if (m->merged[q]) demi_row_put(rows->force, q, demi_add(demi_row(rows->force, q),
                                              demi_scale(m->aside[q], m->t.still[q])));
}
/* Prepares an empty tile for work group d. dt 0: forces only, history does not advance. */
static void demi_member_begin(const dem_world *w, demi_member_tile *m, int d, dem_real dt) {
    m->run = demi_run_of(w, dt, 0);
    m->laws = demi_run_begin(w, dt);
    if (!w->desc.law) demi_run_laws(w, &m->laws, 0);
    m->span.a = m->a;
    m->span.b = m->b;
    m->span.k = m->k;
    m->span.ball = m->ball[0];
    m->span.share = m->t.share;
    m->span.arm = m->t.arm;
    demi_member_clear(m);
    demi_tile_begin(w, d, &m->t.rows);
    m->p[0] = demi_near_first(&w->domains[d]);
    demi_member_coefs(w, m, d, DEMI_TILE, 1);
    memset(m->t.rows.moment, 0, sizeof m->t.rows.moment);
}
/* Turns the torques of a tile about the centres of its spheres into those on the bodies. */
DEMI_CLONES static void demi_member_torques(demi_member_tile *DEMI_RESTRICT m, int turning,
                                            int full) {
    demi_tile *rows = &m->t.rows;
    if (!turning) memset(rows->torque, 0, sizeof rows->torque);
    DEMI_ROWS(full)
        const dem_vec3 f = demi_row(rows->force, q);
        demi_row_put(rows->torque[0], q, demi_add(demi_row(rows->torque[0], q),
                                                  demi_cross(demi_rows_at(&m->t.arm[0], q), f)));
        demi_row_put(rows->torque[1], q, demi_sub(demi_row(rows->torque[1], q),
                                                  demi_cross(demi_rows_at(&m->t.arm[1], q), f)));
    DEMI_ROWS_END
}
/* Evaluates a tile, adds its forces to both bodies and stores its histories. send: 1 if the bodies
   b are of later work groups, so that forces on them go to slots. */
static void demi_member_respond(dem_world *w, demi_member_tile *m, int d, int send) {
    const size_t stride = (size_t)w->near.stride;
    int q, e;
    if (!m->count) return;
    demi_member_evaluate(w, m, d);
    demi_member_torques(m, m->run.turning, (m->count + DEMI_LANES - 1)/DEMI_LANES*DEMI_LANES);
    for (e = 0; e < m->run.keep; e++) {
        dem_real *memory = w->near.memory + ((size_t)d*(size_t)w->memory_stride + (size_t)e)*stride;
        for (q = 0; q < m->count; q++) memory[m->p[q]] = m->t.rows.memory[e][q];
    }
    demi_tile_finish(w, d, &m->t.rows, &m->span, &m->run, send,
                     w->events.n.on ? demi_tile_note : 0);
    if (m->weighted) demi_member_clear(m);
    m->count = 0;
}
/* Computes the weights of n contacts of work group d, of pairs of spheres of the same two bodies,
   into w->merging. hit: their entries. Returns them. */
static const demi_kept *demi_members_merge(const dem_world *w, int d, const int32_t *hit, int n) {
    demi_kept *const first = w->merging + (size_t)d*(size_t)w->merging_most;
    int i;
    for (i = 0; i < n; i++) {
        const size_t at = (size_t)d*(size_t)w->near.stride + (size_t)hit[i];
        const dem_real *x = w->bodies.centre + 4*w->near.ball_a[at];
        const dem_real *y = w->bodies.centre + 4*w->near.ball_b[at];
        demi_kept *c = first + i;
        demi_kept_blank(c);
        c->a = w->near.a[at];
        c->b = w->near.b[at];
        c->part_a = w->near.ball_a[at] - w->bodies.centre_start[c->a];
        c->part_b = w->near.ball_b[at] - w->bodies.centre_start[c->b];
        c->share = c->slope = 1;
        demi_balls_meet(w, demi_at(x), x[3], demi_at(y), y[3], demi_near_way(w, at), c);
    }
    demi_kept_share(w, first, n);
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
/* Computes all pairs of a work group: those of lone spheres (by >>pairs), then the others, first
   those inside the group, then those with later groups. */
static void demi_pairs_members(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    const dem_real dt = w->stage.forces_valid ? w->clock.dt : 0;
    const int merges = w->laws.at_grip < DEMI_MEMORY;
    const int32_t *k = w->near.k + d*w->near.stride;
    int32_t *hit = w->near.hit + d*w->near.stride;
    DEMI_ALIGNED demi_member_tile m;
    int l, p, n, run, i;
    demi_pairs_with(w, d, w->events.n.on ? demi_tile_note : 0);
    if (domain->near_own <= domain->near_lone[0] &&
        domain->near_end <= domain->near_cross + domain->near_lone[1]) return;
    demi_member_begin(w, &m, d, dt);
    for (l = 0; l < 2; l++) {
        const int begin = (l ? domain->near_cross : 0) + domain->near_lone[l];
        const int end = l ? domain->near_end : domain->near_own;
        for (p = begin; l && p < end; p++)
            if (p == begin || k[p] != k[p - 1]) demi_slot_clear(w, k[p]);
        n = demi_members_touch(w, d, begin, end, hit);
        for (p = 0; p < n; p += run) {
            const demi_kept *c = 0;
            for (run = 1; merges && p + run < n && k[hit[p + run]] == k[hit[p]];) run++;
            if (run > 1) c = demi_members_merge(w, d, hit + p, run);
            for (i = 0; i < run; i++) {
                demi_member_add(&m, hit[p + i], c ? c + i : 0);
                if (m.count == DEMI_TILE) demi_member_respond(w, &m, d, l);
            }
        }
        demi_member_respond(w, &m, d, l);
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
    const demi_kept *c = 0;
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
    demi_member_begin(w, &m, d, 0);
    demi_member_add(&m, p, c ? c + at : 0);
    demi_member_evaluate(w, &m, d);
    out->normal = demi_row(m.t.rows.normal, 0);
    out->overlap = m.t.rows.overlap[0];
    out->force = demi_row(m.t.rows.force, 0);
    *gap = demi_rows_at(&m.t.rows.gap, 0);
    return 1;
}
