/* ---------------------------------------------------------------------------------------------
   >>kept-respond
   Response of persistent contacts, a tile of them at a time. For each contact it finds the
   coefficients, which contacts of one kind share (demi_coefs_row), and the history that it
   continues, fills the rows in which the stages of >>respond evaluate the laws, and adds the forces
   to both bodies, the sums of walls, the ledger's energies and the rates of user-defined numbers.
   It also gathers the forces on bodies of later work groups, which wait in slots, for all contacts.
   It owns w->coefs and the histories of persistent contacts, and adds to forces of bodies.
   --------------------------------------------------------------------------------------------- */

/* Works out the coefficients of a contact, without its slope, and the two that are multiplied by
   the square root of m_eff (`root`). */
static void demi_kept_coefs(const dem_world *w, const demi_kept *k, dem_real *out, dem_real *root) {
    const demi_wall *wall = k->b < 0 ? &w->walls[k->wall] : 0;
    const int grains = wall && demi_wall_is(wall, DEMI_BALLS);
    /* here a grain of a wall has mass */
    const int mill = w->desc.convention == DEM_CONVENTION_MILL;
    const double half = mill && grains ? 0.5 : 1;
    const int shaped = demi_shape_of(w, k->a) || (k->b >= 0 && demi_shape_of(w, k->b));
    const double give = shaped ? demi_body_give_at_most(w, k->a) +
        (k->b >= 0 ? demi_body_give_at_most(w, k->b) : 0) : 0;
    demi_coefficients_rooted(w, w->bodies.material[k->a] - 1,
                             wall ? wall->material : w->bodies.material[k->b] - 1, (double)k->r_eff,
                             half*(shaped ? 1/give : (double)w->bodies.mass[k->a]),
                             wall && !grains, out, root);
    root[0] *= (dem_real)sqrt(half);
    root[1] *= (dem_real)sqrt(half);
}
/* Velocity of a body at an arm, m/s: at the full step or, with half_vel, averaged over the step. */
static dem_vec3 demi_velocity_at(const dem_real *v, const dem_real *spin, int body, dem_vec3 arm) {
    return demi_add(demi_at(v + 4*body), demi_cross(demi_at(spin + 4*body), arm));
}
static dem_vec3 demi_surface_at(const dem_pose *pose, dem_vec3 at) {
    return demi_add(pose->velocity, demi_cross(pose->spin, demi_sub(at, pose->position)));
}
/* Copies the history from the contact that c continues. */
DEM_INLINE void demi_kept_recall(const dem_world *w, const demi_kept *now, demi_kept *c) {
    int e;
    if (c->from == DEMI_TAKEN_OVER) return;
    for (e = 0; e < w->memory_stride; e++) {
        DEMI_ONE_BY_ONE(e);                     /* no call of memcpy for so few */
        c->memory[e] = c->from < 0 ? 0 : now[c->from].memory[e];
    }
}
/* Makes room for the coefficients of `more` contacts of work group d. Returns 0 if its rows are
   empty, so that no contact has one yet. */
static int demi_kept_rows_begin(dem_world *w, int d, int more) {
    const int room = 2*(w->kept_first[d + 1] - w->kept_first[d]);
    if (w->domains[d].coefs + more > room) w->domains[d].coefs = 0;
    return w->domains[d].coefs > 0;
}
/* Returns the row with the coefficients of contact c: if `known`, that of `old`, the same contact
   in the step before; otherwise one of the first few rows, or a new one. Masses, materials and
   shapes stay the same while lists are valid: growth drops the lists, and ghosts have their masses
   when forces are computed. */
DEM_INLINE const demi_coefs_row *demi_kept_row(dem_world *w, int d, demi_kept *c,
                                               const demi_kept *old, int known) {
    enum { FEW = 8 };
    demi_coefs_row *rows = w->coefs + 2*(size_t)w->kept_first[d], key, *row;
    int *count = &w->domains[d].coefs, i, most = DEMI_MIN(*count, FEW);
    const int32_t *shape = w->bodies.shape;
    if (known && old->wall == c->wall && old->row >= 0 && old->row < *count &&
        !(rows[old->row].r_eff < c->r_eff || rows[old->row].r_eff > c->r_eff)) {
        c->row = old->row;
        return rows + c->row;
    }
    key.r_eff = c->r_eff;
    key.inv[0] = w->bodies.inv_mass[c->a];
    key.inv[1] = c->b < 0 ? 0 : w->bodies.inv_mass[c->b];
    key.material[0] = w->bodies.material[c->a];
    key.material[1] = c->b < 0 ? -1 - c->wall : w->bodies.material[c->b];
    key.shape[0] = shape ? shape[c->a] : 0;
    key.shape[1] = shape && c->b >= 0 ? shape[c->b] : 0;
    for (i = 0; i < most; i++)
        if (!memcmp(rows + i, &key, offsetof(demi_coefs_row, m_eff))) break;
    c->row = i < most ? i : (*count)++;
    row = rows + c->row;
    if (i < most) return row;
    memcpy(row, &key, offsetof(demi_coefs_row, m_eff));
    row->m_eff = c->b < 0 && !key.shape[0] ? w->bodies.mass[c->a] : 0;
    demi_kept_coefs(w, c, row->coef, row->root);
    return row;
}
/* Returns the history that contact c continues: zeros, that of its old contact, or that with the
   springs of friction and rolling rescaled, because the weight of friction has changed (merged
   contacts, contact points of a surface). If the weight grows, a spring keeps its force; if it
   falls, the spring keeps its length. The reverse would create energy. A contact that has ended in
   this one is merged first: the weighted mean of both springs stores no more energy than the two
   did. */
static const dem_real *demi_kept_past(const dem_world *w, const demi_kept *now, demi_kept *c) {
    const demi_kept *ended = c->b < 0 && c->send ? now + c->send - 1 : 0;
    const dem_real held = c->from < 0 ? 0 : c->held < 0 ? demi_kept_whole(&now[c->from]) : c->held;
    const dem_real more = ended ? demi_kept_whole(ended) : 0, all = held + more;
    const dem_real grip = demi_kept_whole(c), left = grip > all ? all/grip : 1;
    int k;
    if (c->from >= 0 && (!demi_laws_keep(w) || (!ended && !(left < 1)) || !(all > 0 || left < 1)))
        return now[c->from].memory;
    demi_kept_recall(w, now, c);
    if (c->from < 0) return c->memory;
    for (k = 0; k < w->laws.memory; k++) {
        if (!(w->laws.vectors >> k & 1) && k != w->laws.at_twisting) continue;
        if (ended) c->memory[k] = (held*c->memory[k] + more*ended->memory[k])/all;
        c->memory[k] *= left;
    }
    return c->memory;
}
/* Sum of the two radii, m: of spheres, including those of clusters, or the bounding radii of other
   shapes; a wall adds none. */
static dem_real demi_kept_radii(const dem_world *w, const demi_kept *k) {
    return demi_part_now(w, k->a, k->part_a).radius +
        (k->b < 0 ? 0 : demi_part_now(w, k->b, k->part_b).radius);
}
/* Fills in `who` for a persistent contact. */
static void demi_kept_who(const dem_world *w, const demi_kept *k, dem_real *rates,
                          dem_contact_who *who) {
    const dem_real radius = k->b >= 0 ? demi_part_now(w, k->b, k->part_b).radius
        : demi_wall_is(&w->walls[k->wall], DEMI_BALLS) ? w->walls[k->wall].radius : 0;
    demi_who_fill(w, k->a, k->b < 0 ? -1 - k->wall : k->b, demi_part_now(w, k->a, k->part_a).radius,
                  radius, k->arm_a, rates, who);
}
#if defined(__GNUC__) && !defined(__clang__) && !defined(__TINYC__)
#pragma GCC push_options
#pragma GCC optimize("no-trapping-math")
#endif
/* A tile of persistent contacts: what only these need, and the rows for the stages of >>respond. A
   wall is a body b with zero arm: velocities are relative to its surface at the contact point. */
typedef struct demi_kept_tile {
    demi_rows arm[2], mid[2], outset;      /* m, of a and b: now; at mid-step; demi_kept_more */
    demi_rows spin[2], spun[2];    /* rad/s, of a and b: likewise */
    dem_real share[DEMI_ROOM], grip[DEMI_ROOM], lift[DEMI_ROOM];      /* lift: minus share */
    dem_real still[DEMI_ROOM];      /* N, elastic force, if any is lifted */
    dem_real couple[DEMI_ROOM];
    dem_real base[DEMI_COEFS][DEMI_ROOM], root[2][DEMI_ROOM];      /* coefficients without slope */
    dem_real slope[DEMI_ROOM];
    /* for 1/m_eff, if not all bodies are spheres: of a and b */
    demi_rows felt[2];             /* m; 0: does not rotate */
    dem_real q[2][4][DEMI_ROOM], I[2][3][DEMI_ROOM], inv[2][DEMI_ROOM];
    /* the remaining fields are last, so that all rows begin on cache lines */
    demi_tile rows;
    const demi_coefs_row *row[DEMI_TILE];
    const demi_coefs_row *filled[DEMI_TILE];       /* what base and root contain; null: unknown */
    demi_kept *contact[DEMI_TILE];
    const demi_kept *old[DEMI_TILE];               /* what each continues; a new one: itself */
    const dem_real *past[DEMI_TILE];               /* history that each continues */
    dem_vec3 at[DEMI_TILE], surface[DEMI_TILE];    /* point on a wall, m; its velocity */
    int count, lifted, shaped;     /* is `still` needed? bodies that are not spheres? */
} demi_kept_tile;
DEM_INLINE void demi_rows_put(demi_rows *DEMI_RESTRICT rows, int q, dem_vec3 v) {
    DEMI_XY(rows, 0, q) = v.x;
    DEMI_XY(rows, 1, q) = v.y;
    rows->z[q] = v.z;
}
DEM_INLINE dem_vec3 demi_middle(dem_vec3 a, dem_vec3 b) {
    return demi_scale(demi_add(a, b), DEM_R(0.5));
}
/* Fills row q of a contact with a wall, on its wall's side. */
DEM_INLINE void demi_kept_fetch_wall(const demi_run *r, const demi_kept *k, dem_vec3 mid,
                                     demi_kept_tile *t, int q) {
    const dem_world *w = r->w;
    const demi_wall *wall = &w->walls[k->wall];
    const dem_vec3 x = demi_add(demi_at(w->bodies.pos + 4*k->a), k->shift);
    const dem_vec3 uh = demi_at(w->bodies.half_vel + 4*k->a);
    dem_vec3 rate, gone;
    t->at[q] = demi_add(x, k->arm_a);
    t->surface[q] = demi_surface_at(&wall->pose, t->at[q]);
    rate = demi_sub(demi_at(w->bodies.vel + 4*k->a), t->surface[q]);
    if (wall->glides) rate = demi_sub(rate, demi_glide_at(wall, &wall->pose, k->normal));
    demi_rows_put(&t->rows.rate, q, rate);
    demi_rows_put(&t->arm[1], q, demi_v(0, 0, 0));
    demi_rows_put(&t->spin[1], q, wall->pose.spin);
    if (!r->following) return;
    /* velocity relative to the wall at mid-step */
    gone = demi_sub(uh, demi_surface_at(&wall->mid,
                        demi_add(mid, demi_sub(x, demi_scale(uh, r->same.dt/2)))));
    if (wall->glides)                           /* its normal part is removed later */
        gone = demi_sub(gone, demi_rotate(wall->mid.rotation, wall->glide));
    demi_rows_put(&t->rows.gone, q, gone);
    demi_rows_put(&t->mid[1], q, demi_v(0, 0, 0));
    demi_rows_put(&t->spun[1], q, wall->mid.spin);
}
/* Fills row q of a contact of two bodies, on the side of body b. */
DEM_INLINE void demi_kept_fetch_pair(const demi_run *r, const demi_kept *k, const demi_kept *old,
                                     demi_kept_tile *t, int q) {
    const dem_world *w = r->w;
    const dem_real *u = w->bodies.vel, *uh = w->bodies.half_vel;
    demi_rows_minus(&t->rows.rate, (size_t)q, u + 4*k->a, u + 4*k->b);
    if (w->cell.on) demi_rows_flow(w, &t->rows.rate, q, demi_sub(k->arm_a, k->arm_b));
    demi_rows_put(&t->arm[1], q, k->arm_b);
    demi_rows_put(&t->spin[1], q, demi_at(w->bodies.spin + 4*k->b));
    if (!r->following) return;
    demi_rows_minus(&t->rows.gone, (size_t)q, uh + 4*k->a, uh + 4*k->b);
    demi_rows_put(&t->mid[1], q, demi_middle(k->arm_b, old->arm_b));
    demi_rows_put(&t->spun[1], q, demi_at(w->bodies.half_spin + 4*k->b));
    if (w->cell.on)
        demi_rows_flow(w, &t->rows.gone, q, demi_sub(demi_rows_at(&t->mid[0], q),
                                                     demi_rows_at(&t->mid[1], q)));
}
/* Fills row q with the mobility of body `who` (side 0: a, 1: b; negative: a wall) at an arm:
   1/mass, orientation and moments of inertia. */
DEM_INLINE void demi_kept_fetch_felt(const dem_world *w, int who, dem_vec3 arm, int side,
                                     demi_kept_tile *t, int q) {
    const dem_real inv = t->row[q]->inv[side];
    const int turns = inv > 0 && t->row[q]->shape[side];
    int e;
    t->inv[side][q] = inv;
    demi_rows_put(&t->felt[side], q, turns ? arm : demi_v(0, 0, 0));
    if (turns) {
        DEMI_UNROLL
        for (e = 0; e < 4; e++) t->q[side][e][q] = w->bodies.orient[4*who + e];
        DEMI_UNROLL
        for (e = 0; e < 3; e++) t->I[side][e][q] = w->bodies.moment[4*who + e];
        return;
    }
    DEMI_UNROLL
    for (e = 0; e < 4; e++) t->q[side][e][q] = 0;
    DEMI_UNROLL
    for (e = 0; e < 3; e++) t->I[side][e][q] = 1;
}
/* Fills row q with the coefficients of its contact, unless it has them already. */
DEM_INLINE void demi_kept_fetch_coefs(demi_kept_tile *t, int q) {
    const demi_coefs_row *row = t->row[q];
    int e;
    t->rows.coef[DEMI_M_EFF][q] = row->m_eff;
    if (t->filled[q] == row) return;
    for (e = 0; e < DEMI_COEFS; e++) t->base[e][q] = t->rows.coef[e][q] = row->coef[e];
    t->root[0][q] = row->root[0];
    t->root[1][q] = row->root[1];
    t->filled[q] = row;
}
/* Fills row q from a contact and the old one that it continues. */
static void demi_kept_fetch(const demi_run *r, const demi_kept *k, const demi_kept *old,
                            demi_kept_tile *t, int q) {
    const dem_world *w = r->w;
    const dem_vec3 mid = demi_middle(k->arm_a, old->arm_a);
    int e;
    for (e = 0; e < r->keep; e++) t->rows.memory[e][q] = t->past[q][e];
    demi_row_put(t->rows.normal, q, k->normal);
    t->rows.overlap[q] = k->overlap;
    demi_rows_put(&t->arm[0], q, k->arm_a);
    demi_rows_put(&t->spin[0], q, demi_at(w->bodies.spin + 4*k->a));
    if (r->following) {
        demi_row_put(t->rows.turn, q, demi_sub(k->normal, old->normal));
        demi_rows_put(&t->mid[0], q, mid);
        demi_rows_put(&t->spun[0], q, demi_at(w->bodies.half_spin + 4*k->a));
    }
    if (k->b < 0) demi_kept_fetch_wall(r, k, mid, t, q);
    else demi_kept_fetch_pair(r, k, old, t, q);
    demi_kept_fetch_coefs(t, q);
    t->slope[q] = k->slope;
    t->share[q] = k->share;
    t->grip[q] = k->grip;
    t->lift[q] = k->lift - k->share;
    t->couple[q] = k->odd ? k->more.couple : 0;
    demi_rows_put(&t->outset, q, k->odd ? k->more.outset : demi_v(0, 0, 0));
    if (!t->shaped) return;
    demi_kept_fetch_felt(w, k->a, demi_sub(k->arm_a, demi_kept_felt(k)), 0, t, q);
    demi_kept_fetch_felt(w, k->b, demi_sub(k->arm_b, demi_kept_felt(k)), 1, t, q);
}
/* Pads the last vector group of a tile with copies of its last contact, in every row that was
   filled. The padded results are ignored; copies avoid arithmetic on undefined values. */
static void demi_kept_fill_up(demi_kept_tile *t, int keep, int full) {
    dem_real *const rows[] = {t->rows.normal[0], t->rows.overlap, t->rows.turn[0],
        t->rows.memory[0], t->rows.coef[0], t->base[0], t->slope, t->share, t->grip, t->lift,
        t->couple, t->root[0], t->q[0][0], t->I[0][0], t->inv[0]};
    const int counts[] = {3, 1, 3, keep, DEMI_TILE_COLUMNS, DEMI_COEFS, 1, 1, 1, 1, 1,
        2, t->shaped ? 8 : 0, t->shaped ? 6 : 0, t->shaped ? 2 : 0};
    demi_rows *const triples[] = {&t->rows.rate, &t->rows.gone, t->arm, t->arm + 1, t->mid,
        t->mid + 1, &t->outset, t->spin, t->spin + 1, t->spun, t->spun + 1, t->felt, t->felt + 1};
    const int last = t->count - 1;
    int k, e, q;
    for (q = last + 1; q < full; q++) t->filled[q] = 0;
    for (k = 0; k < (int)(sizeof rows/sizeof *rows); k++)
        for (e = 0; e < counts[k]; e++)
            for (q = last + 1; q < full; q++)
                rows[k][e*DEMI_ROOM + q] = rows[k][e*DEMI_ROOM + last];
    for (k = 0; k < (int)(sizeof triples/sizeof *triples) - (t->shaped ? 0 : 2); k++)
        for (q = last + 1; q < full; q++)
            demi_rows_put(triples[k], q, demi_rows_at(triples[k], last));
}
/* Inverse mass, 1/kg, that a force along n finds at its arm: 1/m + (arm x n).I^-1 (arm x n). */
DEM_INLINE dem_real demi_kept_give(demi_kept_tile *DEMI_RESTRICT t, int side, int q) {
    const dem_vec3 c = demi_cross(demi_rows_at(&t->felt[side], q), demi_row(t->rows.normal, q));
    const dem_vec3 v = dem_quat_unrotate(dem_quat_make(t->q[side][0][q], t->q[side][1][q],
                                                       t->q[side][2][q], t->q[side][3][q]), c);
    return t->inv[side][q] + (v.x*v.x/t->I[side][0][q] + v.y*v.y/t->I[side][1][q] +
                              v.z*v.z/t->I[side][2][q]);
}
/* Effective mass m* of a contact, kg: from both bodies at the contact point, unless already
   known. */
DEM_INLINE void demi_kept_mass_one(demi_kept_tile *DEMI_RESTRICT t, int q) {
    const dem_real known = t->rows.coef[DEMI_M_EFF][q];
    const dem_real m = 1/(demi_kept_give(t, 0, q) + demi_kept_give(t, 1, q));
    t->rows.coef[DEMI_M_EFF][q] = known > 0 ? known : m;
}
/* Relative motion at the contact: now, and (following) averaged over the step just taken. */
DEM_INLINE void demi_kept_motion_one(demi_kept_tile *DEMI_RESTRICT t, const demi_same *s, int q,
                                     int following) {
    const dem_vec3 n = demi_row(t->rows.normal, q);
    const dem_vec3 wa = demi_rows_at(&t->spin[0], q), wb = demi_rows_at(&t->spin[1], q);
    const dem_vec3 apart = demi_sub(wa, wb);
    const dem_vec3 u = demi_sub(demi_add(demi_rows_at(&t->rows.rate, q),
                                         demi_cross(wa, demi_rows_at(&t->arm[0], q))),
                                demi_cross(wb, demi_rows_at(&t->arm[1], q)));
    const dem_real closing = demi_dot(u, n), slope = t->slope[q];       /* d overlap/d approach */
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
        const dem_real per = s->dt > 0 ? 1/s->dt : 0;
        const dem_vec3 way = demi_row(t->rows.turn, q);
        const dem_vec3 mid = demi_sub(n, demi_scale(way, DEM_R(0.5)));
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
/* Force and torques of a contact, each part times its weight. */
DEM_INLINE void demi_kept_answer_one(demi_kept_tile *DEMI_RESTRICT t, int q, int rolls) {
    const dem_vec3 n = demi_row(t->rows.normal, q);
    const dem_real press = t->share[q]*t->rows.repulsion[q] + t->lift[q]*t->still[q];
    const dem_vec3 push = demi_scale(n, press);
    const dem_vec3 force = demi_sub(demi_scale(demi_row(t->rows.tangent, q), t->grip[q]), push);
    dem_vec3 moment = demi_scale(push, -t->couple[q]);
    if (rolls) moment = demi_add(moment, demi_scale(demi_row(t->rows.moment, q), t->grip[q]));
    demi_row_put(t->rows.force, q, force);
    demi_row_put(t->rows.moment, q, moment);
    demi_row_put(t->rows.torque[0], q, demi_add(demi_add(demi_cross(demi_rows_at(&t->arm[0], q),
                 force), demi_cross(demi_rows_at(&t->outset, q), push)), moment));
    demi_row_put(t->rows.torque[1], q,
                 demi_scale(demi_add(demi_cross(demi_rows_at(&t->arm[1], q), force), moment), -1));
}
#define DEMI_KEPT_STAGE(NAME, ONE) \
    DEMI_CLONES static void NAME(demi_kept_tile *DEMI_RESTRICT t, const demi_run *r, int full) { \
        const demi_same s = r->same; \
        (void)s; \
        DEMI_ROWS(full) ONE; DEMI_ROWS_END \
    }
DEMI_KEPT_STAGE(demi_kept_mass, demi_kept_mass_one(t, q))
DEMI_KEPT_STAGE(demi_kept_motion, demi_kept_motion_one(t, &s, q, 0))
DEMI_KEPT_STAGE(demi_kept_motion_following, demi_kept_motion_one(t, &s, q, 1))
DEMI_KEPT_STAGE(demi_kept_answer, demi_kept_answer_one(t, q, 0))
DEMI_KEPT_STAGE(demi_kept_answer_rolling, demi_kept_answer_one(t, q, 1))
#undef DEMI_KEPT_STAGE
#if defined(__GNUC__) && !defined(__clang__) && !defined(__TINYC__)
#pragma GCC pop_options
#endif

/* True if the elastic force is not along the normal. */
DEM_INLINE int demi_kept_aslant(const demi_kept *k) {
    return k->odd && demi_dot(k->more.aside, k->more.aside) > 0;
}
/* True if the weight of the elastic force differs from that of the dashpot. */
DEM_INLINE int demi_kept_lifted(const demi_kept *k) {
    return k->lift < k->share || k->lift > k->share || demi_kept_aslant(k);
}
/* Fills a dem_contact from row q for a law that is called contact by contact. */
static void demi_kept_see(const dem_world *w, demi_kept_tile *t, const demi_run *r, int q,
                          dem_contact *c) {
    const demi_kept *k = t->contact[q];
    demi_tile_contact(&t->rows, &r->same, q, c);
    if (!w->desc.law) return;
    demi_who_clear(&c->who);
    c->range = r->ranged ? demi_range(w, demi_kept_radii(w, k)) : 0;
    c->material_a = w->bodies.material[k->a];
    c->material_b = k->b >= 0 ? w->bodies.material[k->b] : w->walls[k->wall].material + 1;
    c->wall = k->b >= 0 ? 0 : w->walls[k->wall].id;
    c->user = w->desc.law_user;
    if (w->desc.law_who) demi_kept_who(w, k, t->rows.gains[q], &c->who);
}
/* Calls the law for row q of a tile. still: null, or where only the elastic force goes: the contact
   is at rest then, and keeps its history. */
static void demi_row_law(const dem_world *w, demi_tile *t, const demi_run *r, int q, dem_contact *c,
                         dem_real *still) {
    dem_real m[DEMI_MEMORY];
    dem_contact_force f;
    if (still) c->closing_speed = 0;
    demi_recall(t, q, 0, r->keep, m);
    demi_law(w, c, m, &f);
    if (still) { *still = f.normal; return; }
    demi_keep(t, q, 0, r->keep, m);
    demi_normal_put(t, &r->same, q, &f, 2);
    demi_tangent_put(t, &r->same, q, &f, 2);
    demi_rolling_put(t, &r->same, q, &f, 2);
}
/* Evaluates laws contact by contact: a user-defined law, or built-in laws for a few contacts. */
static void demi_kept_laws(const dem_world *w, demi_kept_tile *t, const demi_run *r) {
    dem_contact c;
    int q, rests;
    for (q = 0; q < t->count; q++)
        for (t->still[q] = 0, rests = demi_kept_lifted(t->contact[q]); rests >= 0; rests--) {
            demi_kept_see(w, t, r, q, &c);
            demi_row_law(w, &t->rows, r, q, &c, rests ? &t->still[q] : 0);
        }
}
/* Evaluates the normal law at zero closing speed: the elastic force alone, N. History is
   restored. */
static void demi_kept_still(demi_kept_tile *t, const demi_run *r, int full) {
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
/* Adds a force and a moment on a body at point `at` to the sums of its wall, with opposite sign.
   surface: velocity of the wall there, m/s. */
DEM_INLINE void demi_wall_sum_add(const dem_world *w, demi_wall_sum *sum, int wall, dem_vec3 at,
                              dem_vec3 force, dem_vec3 moment, dem_vec3 surface) {
    const dem_vec3 arm = demi_sub(at, w->walls[wall].motion.point);
    const dem_vec3 torque = demi_add(demi_cross(arm, force), moment);
    sum->force[0] -= (double)force.x; sum->force[1] -= (double)force.y;
    sum->force[2] -= (double)force.z;
    sum->torque[0] -= (double)torque.x; sum->torque[1] -= (double)torque.y;
    sum->torque[2] -= (double)torque.z;
    sum->power += (double)(demi_dot(force, surface) + demi_dot(moment, w->walls[wall].pose.spin));
}
/* Velocity, m/s, by which a and b (b < 0: a wall) closed faster than predicted. */
DEM_INLINE dem_vec3 demi_late_of(const dem_world *w, int a, int b) {
    const dem_vec3 late = demi_at(w->bodies.late + 4*a);
    return b < 0 ? late : demi_sub(late, demi_at(w->bodies.late + 4*b));
}
/* Computes the energies of the contact of row q, J, for the ledger. Friction and rolling may have
   another weight than the rest: see demi_kept_lift. */
static void demi_kept_energy(const dem_world *w, const demi_kept_tile *t, int q, double *energy) {
    const demi_tile *rows = &t->rows;
    const demi_kept *c = t->contact[q];
    const dem_real share = c->share, grip = c->grip, slope = c->slope;
    const dem_real late = !w->bodies.booked ? 0
        : demi_late_share(demi_late_of(w, c->a, c->b), c->normal, rows->closing[q]);
    /* V = k overlap^2/2; the law was given k slope */
    energy[DEMI_E_DASHPOT] = (double)(share*(rows->part[0][q]*(1 + late) + rows->part[6][q]/slope));
    energy[DEMI_E_ELASTIC] = (double)(share*(rows->part[1][q]/slope));
    energy[DEMI_E_SHEAR_WORK] = (double)(grip*rows->part[2][q]);
    energy[DEMI_E_SLIDE] = (double)(grip*rows->part[3][q]);
    energy[DEMI_E_SHEAR_STORED] = (double)(grip*rows->part[4][q]);
    energy[DEMI_E_ROLL] = (double)(grip*rows->part[5][q]);
}
/* Notes the contact of row q for events. */
static DEMI_APART void demi_kept_note(dem_world *w, int d, const demi_kept_tile *t, int q,
                                      const double *energy) {
    const demi_kept *c = t->contact[q];
    demi_noted_at *at = demi_note(w, d, c->a, c->b < 0 ? -1 - c->wall : c->b, c->from >= 0,
                                  c->overlap > 0, -demi_dot(c->force, c->normal), energy);
    if (!at) return;
    at->normal = c->normal;
    at->arm = c->arm_a;
    at->shift = c->shift;
}

/* Adds the rates that a law returned for user-defined numbers, times the weight of contact c. */
static DEMI_APART void demi_kept_rates(dem_world *w, int d, const demi_kept *c,
                                       const dem_real *rates) {
    const int n = w->bodies.real_count;
    double *wall = c->b >= 0 ? 0 : w->wall_rates +
        (size_t)n*((size_t)d*(size_t)w->wall_count + (size_t)c->wall);
    dem_real *b = c->b < 0 ? 0 : c->send ? w->cross_rate + (size_t)n*(size_t)(c->send - 1)
        : w->bodies.rates + n*c->b;
    int k;
    for (k = 0; k < n; k++) {
        const dem_real gain = c->share*rates[DEM_BODY_REALS + k];
        w->bodies.rates[n*c->a + k] += c->share*rates[k];
        if (b) b[k] += gain;
        else wall[k] += (double)gain;
    }
}
/* Prefetches a body that a later contact will read and change. */
DEM_INLINE void demi_body_fetch(const dem_world *w, int body) {
    DEMI_FETCH(w->bodies.vel + 4*body);
    DEMI_FETCH(w->bodies.half_vel + 4*body);
    DEMI_FETCH(w->bodies.spin + 4*body);
    DEMI_FETCH(w->bodies.half_spin + 4*body);
    DEMI_FETCH(w->bodies.force + 4*body);
    DEMI_FETCH(w->bodies.torque + 4*body);
    if (!w->bodies.shaped) return;
    DEMI_FETCH(w->bodies.orient + 4*body);
    DEMI_FETCH(w->bodies.moment + 4*body);
}
/* Adds the tangential force of merged contacts (`aside`). It acts on a at the centre of its
   sphere, and on b at the point that the normal rotates about, 1/bend or 1/along away. */
static void demi_kept_aside_add(const dem_world *w, demi_kept_tile *t, int q) {
    const demi_kept *c = t->contact[q];
    const dem_vec3 aside = demi_scale(c->more.aside, t->still[q]);
    const dem_vec3 arm = demi_sub(demi_part_now(w, c->a, c->part_a).centre, c->arm_a);
    const dem_real turn = c->bend < 0 || c->bend > 0 ? c->bend : c->more.along;
    const dem_vec3 far = demi_sub(arm, demi_scale(c->normal, 1/turn));
    const dem_vec3 moment = demi_cross(far, aside);
    demi_row_put(t->rows.force, q, demi_add(demi_row(t->rows.force, q), aside));
    demi_row_put(t->rows.moment, q, demi_add(demi_row(t->rows.moment, q), moment));
    demi_row_put(t->rows.torque[0], q, demi_add(demi_row(t->rows.torque[0], q),
                          demi_cross(demi_add(c->arm_a, arm), aside)));
    demi_row_put(t->rows.torque[1], q, demi_sub(demi_row(t->rows.torque[1], q),
                          demi_add(demi_cross(c->arm_b, aside), moment)));
}
/* Returns the force of row q on a, and sets *moment, as its wall has them: with its own pressure,
   while a has its part of all (demi_kept_more). Over all parts, the two are the same. */
DEM_INLINE dem_vec3 demi_kept_own(demi_kept_tile *t, int q, dem_vec3 *moment) {
    const demi_kept *c = t->contact[q];
    dem_real press;
    *moment = demi_row(t->rows.moment, q);
    if (!c->odd || !(c->more.part > 0)) return demi_row(t->rows.force, q);
    press = t->share[q]*t->rows.repulsion[q];
    *moment = demi_sub(*moment, demi_scale(c->more.turn, press));
    return demi_sub(demi_row(t->rows.force, q), demi_scale(c->more.lean, press));
}
/* Adds the force of row q to both bodies, or to body a and the sums of its wall. */
static void demi_kept_push(dem_world *w, int d, demi_kept_tile *t, int q) {
    demi_kept *c = t->contact[q];
    const dem_vec3 force = demi_row(t->rows.force, q);
    demi_force_add(w->bodies.force + 4*c->a, force);
    if (demi_turns(w))                          /* else nothing sets torques to 0 in a step */
        demi_force_add(w->bodies.torque + 4*c->a, demi_row(t->rows.torque[0], q));
    if (c->b >= 0) {                            /* several contacts may share a slot */
        dem_real *out = c->send ? w->cross_force + 6*(size_t)(c->send - 1) : 0;
        c->force = force;
        demi_force_add(out ? out : w->bodies.force + 4*c->b, demi_scale(force, -1));
        demi_force_add(out ? out + 3 : w->bodies.torque + 4*c->b, demi_row(t->rows.torque[1], q));
    } else {
        const demi_wall *wall = &w->walls[c->wall];
        demi_wall_sum *sum = &w->wall_sums[(size_t)d*(size_t)w->wall_count + (size_t)c->wall];
        dem_vec3 moment;
        c->force = demi_kept_own(t, q, &moment);
        demi_wall_sum_add(w, sum, c->wall, t->at[q], c->force, moment, t->surface[q]);
        if (wall->glides)                       /* only friction does work on a gliding surface */
            sum->power += (double)(t->grip[q]*demi_dot(demi_row(t->rows.tangent, q),
                demi_glide_at(wall, &wall->pose, c->normal)));
    }
}
/* Evaluates the contacts of a tile. Fewer than four are evaluated one by one, since a vector group
   costs as much for one contact as for all that fit. Results are the same to the bit. */
static void demi_kept_tile_answer(const dem_world *w, const demi_run *r, demi_kept_tile *t) {
    const int full = (t->count + DEMI_LANES - 1)/DEMI_LANES*DEMI_LANES;
    const int few = t->count < 4, rolls = demi_laws_roll(w);
    int q, k;
    for (q = 0; q < t->count; q++)
        demi_kept_fetch(r, t->contact[q], t->old[q], t, q);
    if (few) {
        for (q = 0; q < t->count && t->shaped; q++) demi_kept_mass_one(t, q);
        for (q = 0; q < t->count; q++) demi_kept_motion_one(t, &r->same, q, r->following);
        demi_kept_laws(w, t, r);
        for (q = 0; q < t->count; q++) demi_kept_answer_one(t, q, rolls);
        return;
    }
    demi_kept_fill_up(t, r->keep, full);
    if (t->shaped) demi_kept_mass(t, r, full);
    (r->following ? demi_kept_motion_following : demi_kept_motion)(t, r, full);
    if (w->desc.law) demi_kept_laws(w, t, r);
    else {
        if (t->lifted) demi_kept_still(t, r, full);
        for (k = 0; k < DEMI_STAGES && r->stage[k]; k++) r->stage[k](&t->rows, r, full);
    }
    (rolls ? demi_kept_answer_rolling : demi_kept_answer)(t, r, full);
}
/* Evaluates a tile, then adds forces to both sides, updates sums of walls, energies and history. */
static void demi_kept_tile_respond(dem_world *w, int d, const demi_run *r, demi_kept_tile *t) {
    demi_domain *domain = &w->domains[d];
    demi_tile *rows = &t->rows;
    double energy[DEMI_E_ROLL + 1];
    int q, e;
    demi_kept_tile_answer(w, r, t);
    for (q = 0; q < t->count; q++) {
        demi_kept *c = t->contact[q];
        for (e = 0; e < r->keep; e++) c->memory[e] = rows->memory[e][q];
        if (t->lifted && demi_kept_aslant(c)) demi_kept_aside_add(w, t, q);
        demi_kept_push(w, d, t, q);
        if (w->cell.on && c->b >= 0)
            demi_tile_cell(w, rows, q, demi_sub(c->arm_a, c->arm_b), c->slope*c->lift,
                           domain->cell);
        if (demi_exchanges(w)) demi_kept_rates(w, d, c, rows->gains[q]);
        if (!r->ledger) continue;
        demi_kept_energy(w, t, q, energy);
        for (e = 0; e <= DEMI_E_ROLL; e++) domain->energy[e] += energy[e];
        if (w->events.n.on) demi_kept_note(w, d, t, q, energy);
    }
    t->count = t->lifted = t->shaped = 0;
}
/* Counts a contact that a law is evaluated for: materials that have touched, largest overlap,
   numbers of contacts. fresh: it begins to touch in this step. */
static void demi_kept_count(dem_world *w, int d, const demi_kept *c, int fresh) {
    demi_domain *domain = &w->domains[d];
    const int touches = c->overlap > 0;
    if (touches && fresh) {
        const int a = w->bodies.material[c->a] - 1;
        const int b = c->b >= 0 ? w->bodies.material[c->b] - 1 : w->walls[c->wall].material;
        domain->met[DEMI_MIN(a, b)] |= UINT64_C(1) << DEMI_MAX(a, b);
    }
    domain->overlap = DEMI_MAX(domain->overlap, (double)c->deep);
    if (c->b >= 0) {
        domain->contacts += touches && !c->corner;
        return;
    }
    w->wall_sums[(size_t)d*(size_t)w->wall_count + (size_t)c->wall].contacts +=
        touches && !c->corner;
    domain->kept_walls += touches;
}
/* Empties a tile and sets what adding a contact does not set, in the first `rows` rows. */
static void demi_kept_tile_begin(demi_kept_tile *t, const demi_run *r, int rows) {
    int q;
    t->count = t->lifted = t->shaped = 0;
    for (q = 0; q < DEMI_TILE && q < rows; q++) {
        t->rows.touch[q] = 1;
        t->rows.memory[DEMI_MEMORY][q] = 0;
        t->filled[q] = 0;
        t->still[q] = 0;                        /* if none is lifted */
        demi_row_put(t->rows.tangent, q, demi_v(0, 0, 0));      /* if no law sets it */
        t->rows.slope[0][q] = t->rows.slope[1][q] = t->rows.kt[1][q] = (dem_real)NAN;
    }
    if (r->ledger) memset(t->rows.part, 0, sizeof t->rows.part);
}
/* Appends contact c, which continues `old` with history `past` and has coefficients `row`, to a
   tile. */
DEM_INLINE void demi_kept_tile_add(demi_kept_tile *t, demi_kept *c, const demi_kept *old,
                                   const dem_real *past, const demi_coefs_row *row) {
    t->contact[t->count] = c;
    t->past[t->count] = past;
    t->row[t->count] = row;
    t->old[t->count++] = old;
    t->lifted |= demi_kept_lifted(c);
    t->shaped |= !(row->m_eff > 0);
}
/* Evaluates all persistent contacts of a work group in list order. */
static void demi_kept_respond(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    const dem_real dt = w->stage.forces_valid ? w->clock.dt : 0;
    const demi_kept *now = demi_kept_of(w, d);
    DEMI_ALIGNED demi_kept_tile tile;
    demi_run run = demi_run_begin(w, dt);
    int i, known;
    domain->kept_walls = 0;
    if (!domain->kept_next) return;
    known = demi_kept_rows_begin(w, d, domain->kept_next);
    if (!w->desc.law) demi_run_laws(w, &run, 0);
    demi_kept_tile_begin(&tile, &run, domain->kept_next + DEMI_LANES);
    for (i = 0; i < domain->kept_next; i++) {
        demi_kept *c = w->kept_next + w->kept_first[d] + i;
        const demi_kept *old = c->from < 0 ? c : now + c->from;
        if (i + 5 < domain->kept_next) demi_kept_ahead(c, 5, 1);
        if (i + 2 < domain->kept_next) {
            demi_body_fetch(w, c[2].a);
            if (c[2].b >= 0) demi_body_fetch(w, c[2].b);
            if (c[2].from >= 0) demi_kept_ahead(now, (size_t)c[2].from, 0);
        }
        if (!demi_kept_asked(w, c)) {           /* on its way through a reduced hole */
            demi_kept_recall(w, now, c);
            c->row = -1;
            c->force = demi_v(0, 0, 0);
            domain->kept_walls += c->b < 0;
            continue;
        }
        demi_kept_tile_add(&tile, c, old, demi_kept_past(w, now, c),
                           demi_kept_row(w, d, c, old, known && old != c));
        demi_kept_count(w, d, c, c->from < 0 || !(old->overlap > 0));
        if (tile.count == DEMI_TILE) demi_kept_tile_respond(w, d, &run, &tile);
    }
    if (tile.count) demi_kept_tile_respond(w, d, &run, &tile);
}
/* Clears the slot of a candidate with a later work group: its contacts add to it. */
static void demi_slot_clear(dem_world *w, int k) {
    const size_t rates = demi_exchanges(w) ? (size_t)w->bodies.real_count : 0;
    memset(w->cross_force + 6*(size_t)k, 0, 6*sizeof(dem_real));
    if (rates) memset(w->cross_rate + rates*(size_t)k, 0, rates*sizeof(dem_real));
}
/* Clears the slots of all pairs of bodies that may have persistent contacts. */
static void demi_kept_clear(dem_world *w, int d) {
    const demi_domain *domain = &w->domains[d];
    int p;
    for (p = domain->near_shaped_cross; p < domain->near_shaped_end; p++)
        demi_slot_clear(w, w->near.k[d*w->near.stride + p]);
}

/* Adds the forces that pairs of earlier work groups left in slots for bodies of work group d. */
static void demi_cross_gather(dem_world *w, int d) {
    const int spins = demi_spins(w), rates = demi_exchanges(w) ? w->bodies.real_count : 0;
    int k, e;
    for (k = w->cross_incoming_start[d]; k < w->cross_incoming_start[d + 1]; k++) {
        const int entry = w->cross_incoming[k], j = 4*w->cross.b[entry];
        const dem_real *force = w->cross_force + 6*(size_t)entry;
        const int turning = spins || demi_shape_of(w, w->cross.a[entry]) || demi_shape_of(w, j/4);
        if (!w->cross.place[entry]) continue;   /* not in the pruned list */
        for (e = 0; e < 3; e++) {
            w->bodies.force[j + e] += force[e];
            if (turning) w->bodies.torque[j + e] += force[3 + e];
        }
        for (e = 0; e < rates; e++)
            w->bodies.rates[rates*(j/4) + e] += w->cross_rate[(size_t)(rates*entry + e)];
    }
}
