/* ---------------------------------------------------------------------------------------------
   >>persistent-respond
   Response of persistent contacts. For each contact it finds the coefficients, which contacts of
   one kind share (demi_coefs_row), and the history that it continues, and fills tiles of >>points.
   It also gathers the forces on bodies of later work groups, which wait in slots, for all contacts.
   It owns w->coefs and the histories of persistent contacts.
   --------------------------------------------------------------------------------------------- */

/* Works out the coefficients of a contact, without its slope, and the two that are multiplied by
   the square root of m_eff (`root`). */
static void demi_persistent_coefs(const dem_world *w, const demi_persistent *k, dem_real *out,
                                  dem_real *root) {
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
DEM_INLINE void demi_persistent_recall(const dem_world *w, const demi_persistent *now,
                                       demi_persistent *c) {
    int e;
    if (c->from == DEMI_TAKEN_OVER) return;
    for (e = 0; e < w->memory_stride; e++) {
        DEMI_ONE_BY_ONE(e);                     /* no call of memcpy for so few */
        c->memory[e] = c->from < 0 ? 0 : now[c->from].memory[e];
    }
}
/* Makes room for the coefficients of `more` contacts of work group d. Returns 0 if its rows are
   empty, so that no contact has one yet. */
static int demi_persistent_rows_begin(dem_world *w, int d, int more) {
    const int room = 2*(w->persistent_first[d + 1] - w->persistent_first[d]);
    if (w->domains[d].coefs + more > room) w->domains[d].coefs = 0;
    return w->domains[d].coefs > 0;
}
/* Returns the row with the coefficients of contact c: if `known`, that of `old`, the same contact
   in the step before; otherwise one of the first few rows, or a new one. Masses, materials and
   shapes stay the same while lists are valid: growth drops the lists, and ghosts have their masses
   when forces are computed. */
DEM_INLINE const demi_coefs_row *demi_persistent_row(dem_world *w, int d, demi_persistent *c,
                                                     const demi_persistent *old, int known) {
    enum { FEW = 8 };
    demi_coefs_row *rows = w->coefs + 2*(size_t)w->persistent_first[d], key, *row;
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
    demi_persistent_coefs(w, c, row->coef, row->root);
    return row;
}
/* Returns the history that contact c continues: zeros, that of its old contact, or that with the
   springs of friction and rolling rescaled, because the weight of friction has changed (merged
   contacts, contact points of a surface). If the weight grows, a spring keeps its force; if it
   falls, the spring keeps its length. The reverse would create energy. A contact that has ended in
   this one is merged first: the weighted mean of both springs stores no more energy than the two
   did. */
static const dem_real *demi_persistent_past(const dem_world *w, const demi_persistent *now,
                                            demi_persistent *c) {
    const demi_persistent *ended = c->b < 0 && c->send ? now + c->send - 1 : 0;
    const dem_real held = c->from < 0 ? 0 : c->held < 0 ? demi_persistent_whole(&now[c->from])
        : c->held;
    const dem_real more = ended ? demi_persistent_whole(ended) : 0, all = held + more;
    const dem_real grip = demi_persistent_whole(c), left = grip > all ? all/grip : 1;
    int k;
    if (c->from >= 0 && (!demi_laws_keep(w) || (!ended && !(left < 1)) || !(all > 0 || left < 1)))
        return now[c->from].memory;
    demi_persistent_recall(w, now, c);
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
static dem_real demi_persistent_radii(const dem_world *w, const demi_persistent *k) {
    return demi_part_now(w, k->a, k->part_a).radius +
        (k->b < 0 ? 0 : demi_part_now(w, k->b, k->part_b).radius);
}
DEM_INLINE dem_vec3 demi_middle(dem_vec3 a, dem_vec3 b) {
    return demi_scale(demi_add(a, b), DEM_R(0.5));
}
/* Fills row q of a contact with a wall, on its wall's side. */
DEM_INLINE void demi_persistent_fetch_wall(const demi_run *r, const demi_persistent *k,
                                           dem_vec3 mid, demi_points *t, int q) {
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
DEM_INLINE void demi_persistent_fetch_pair(const demi_run *r, const demi_persistent *k,
                                           const demi_persistent *old, demi_points *t, int q) {
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
/* Fills row q with the coefficients of its contact, unless it has them already. */
DEM_INLINE void demi_persistent_fetch_coefs(demi_points *t, int q, const demi_coefs_row *row) {
    int e;
    t->rows.coef[DEMI_M_EFF][q] = t->known[q] = row->m_eff;
    t->turns |= !(row->m_eff > 0);
    if (t->filled[q] == row) return;
    for (e = 0; e < DEMI_COEFS; e++) t->base[e][q] = t->rows.coef[e][q] = row->coef[e];
    t->root[0][q] = row->root[0];
    t->root[1][q] = row->root[1];
    t->filled[q] = row;
}
/* Fills row q with what the effective mass of its contact depends on. */
DEM_INLINE void demi_persistent_fetch_felt(const dem_world *w, const demi_persistent *k,
                                           demi_points *t, int q) {
    const dem_vec3 felt = demi_persistent_felt(k);
    const dem_real *a = w->bodies.yield + 6*k->a, *b = w->bodies.yield + 6*DEMI_MAX(k->b, 0);
    const dem_real both = k->b < 0 ? DEM_R(0) : DEM_R(1);
    int e;
    demi_rows_put(&t->felt[0], q, demi_sub(k->arm_a, felt));
    demi_rows_put(&t->felt[1], q, demi_sub(k->arm_b, felt));
    t->inv[q] = w->bodies.inv_mass[k->a] + (k->b < 0 ? 0 : w->bodies.inv_mass[k->b]);
    DEMI_UNROLL
    for (e = 0; e < 6; e++) {
        t->yield[0][e][q] = a[e];
        t->yield[1][e][q] = b[e]*both;
    }
}
/* Appends contact c, which continues `old` with the history `past` and has the coefficients `row`,
   to a tile. */
static void demi_persistent_add(demi_points *t, demi_persistent *c, const demi_persistent *old,
                                const dem_real *past, const demi_coefs_row *row) {
    const demi_run *r = &t->run;
    const dem_world *w = r->w;
    const dem_vec3 mid = demi_middle(c->arm_a, old->arm_a);
    const int q = t->count++;
    int e;
    t->contact[q] = c;
    t->a[q] = c->a;
    t->b[q] = c->b < 0 ? -1 - c->wall : c->b;
    t->k[q] = c->b < 0 ? -1 : c->send - 1;
    t->home[q] = c->memory;
    for (e = 0; e < r->keep; e++) t->rows.memory[e][q] = past[e];
    demi_row_put(t->rows.normal, q, c->normal);
    t->rows.overlap[q] = c->overlap;
    demi_rows_put(&t->arm[0], q, c->arm_a);
    demi_rows_put(&t->spin[0], q, demi_at(w->bodies.spin + 4*c->a));
    if (r->following) {
        demi_row_put(t->rows.turn, q, r->same.dt > 0 ? demi_sub(c->normal, old->normal)
                     : demi_v(0, 0, 0));
        demi_rows_put(&t->mid[0], q, mid);
        demi_rows_put(&t->spun[0], q, demi_at(w->bodies.half_spin + 4*c->a));
    }
    if (c->b < 0) demi_persistent_fetch_wall(r, c, mid, t, q);
    else demi_persistent_fetch_pair(r, c, old, t, q);
    demi_persistent_fetch_coefs(t, q, row);
    demi_points_weights(w, t, q, c);
    t->couple[q] = c->odd ? c->more.couple : 0;
    demi_rows_put(&t->outset, q, c->odd ? c->more.outset : demi_v(0, 0, 0));
    if (w->bodies.shaped) demi_persistent_fetch_felt(w, c, t, q);
    if (!w->desc.law) return;
    t->rows.radius[0][q] = demi_part_now(w, c->a, c->part_a).radius;
    t->rows.radius[1][q] = c->b < 0 ? 0 : demi_part_now(w, c->b, c->part_b).radius;
}
/* Pads the last vector group of a tile with copies of its last contact, in every row that was
   filled, unless an earlier contact has left something. The padded results are ignored; copies
   avoid arithmetic on undefined values. */
static void demi_persistent_fill_up(demi_points *t, int full) {
    const int last = t->count - 1, shaped = t->run.w->bodies.shaped;
    dem_real *const rows[] = {t->rows.normal[0], t->rows.overlap, t->rows.turn[0],
        t->rows.memory[0], t->rows.coef[0], t->base[0], t->slope, t->share, t->grip, t->lift,
        t->couple, t->root[0], t->known, t->inv, t->yield[0][0]};
    const int counts[] = {3, 1, 3, t->run.keep, DEMI_TILE_COLUMNS, DEMI_COEFS, 1, 1, 1, 1,
        1, 2, 1, shaped ? 1 : 0, shaped ? 12 : 0};
    demi_rows *const triples[] = {&t->rows.rate, &t->rows.gone, t->arm, t->arm + 1, t->mid,
        t->mid + 1, &t->outset, t->spin, t->spin + 1, t->spun, t->spun + 1, t->felt, t->felt + 1};
    const int from = DEMI_MAX(last + 1, t->ready);
    int k, e, q;
    for (k = 0; k < (int)(sizeof rows/sizeof *rows); k++)
        for (e = 0; e < counts[k]; e++)
            for (q = from; q < full; q++)
                rows[k][e*DEMI_ROOM + q] = rows[k][e*DEMI_ROOM + last];
    for (k = 0; k < (int)(sizeof triples/sizeof *triples) - (shaped ? 0 : 2); k++)
        for (q = from; q < full; q++)
            demi_rows_put(triples[k], q, demi_rows_at(triples[k], last));
    t->ready = DEMI_MAX(t->ready, full);
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
    DEMI_FETCH(w->bodies.yield + 6*body);
}
/* Prepares an empty tile for up to `count` contacts: see demi_points_begin. */
static void demi_persistent_tile_begin(const dem_world *w, demi_points *t, dem_real dt, int count) {
    demi_points_begin(w, t, dt, count + DEMI_LANES);
    if (w->desc.law) t->run.stage[1] = demi_stage_own;      /* rows of contacts know no wall */
    t->hop = 1;
}
/* Evaluates the contacts of a tile. */
static void demi_persistent_evaluate(const dem_world *w, demi_points *t) {
    demi_persistent_fill_up(t, (t->count + DEMI_LANES - 1)/DEMI_LANES*DEMI_LANES);
    demi_points_evaluate(w, t);
}
/* Evaluates a tile and adds its results. */
static void demi_persistent_tile_respond(dem_world *w, int d, demi_points *t) {
    demi_persistent_evaluate(w, t);
    demi_points_finish(w, d, t);
}
/* Counts a contact that a law is evaluated for: materials that have touched, largest overlap,
   numbers of contacts. fresh: it begins to touch in this step. */
static void demi_persistent_count(dem_world *w, int d, const demi_persistent *c, int fresh) {
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
    domain->persistent_walls += touches;
}
/* Evaluates all persistent contacts of a work group in list order. */
static void demi_persistent_respond(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    const dem_real dt = w->stage.forces_valid ? w->clock.dt : 0;
    const demi_persistent *now = demi_persistent_of(w, d);
    DEMI_ALIGNED demi_points tile;
    int i, known;
    domain->persistent_walls = 0;
    if (!domain->persistent_next) return;
    known = demi_persistent_rows_begin(w, d, domain->persistent_next);
    demi_persistent_tile_begin(w, &tile, dt, domain->persistent_next);
    for (i = 0; i < domain->persistent_next; i++) {
        demi_persistent *c = w->persistent_next + w->persistent_first[d] + i;
        const demi_persistent *old = c->from < 0 ? c : now + c->from;
        if (i + 5 < domain->persistent_next) demi_persistent_ahead(c, 5, 1);
        if (i + 2 < domain->persistent_next) {
            demi_body_fetch(w, c[2].a);
            if (c[2].b >= 0) demi_body_fetch(w, c[2].b);
            if (c[2].from >= 0) demi_persistent_ahead(now, (size_t)c[2].from, 0);
        }
        if (!demi_persistent_asked(w, c)) {     /* on its way through a reduced hole */
            demi_persistent_recall(w, now, c);
            c->row = -1;
            c->force = demi_v(0, 0, 0);
            domain->persistent_walls += c->b < 0;
            continue;
        }
        /* >>persistent does this for all bodies if pairs may need it */
        if (w->bodies.shaped && !w->effects.unlike) demi_yields_turn(w, c->a, c->a + 1);
        demi_persistent_add(&tile, c, old, demi_persistent_past(w, now, c),
                            demi_persistent_row(w, d, c, old, known && old != c));
        demi_persistent_count(w, d, c, c->from < 0 || !(old->overlap > 0));
        if (tile.count == DEMI_TILE) demi_persistent_tile_respond(w, d, &tile);
    }
    if (tile.count) demi_persistent_tile_respond(w, d, &tile);
}
/* Clears the slot of a candidate with a later work group: its contacts add to it. */
static void demi_slot_clear(dem_world *w, int k) {
    const size_t rates = demi_exchanges(w) ? (size_t)w->bodies.real_count : 0;
    memset(w->cross_force + 6*(size_t)k, 0, 6*sizeof(dem_real));
    if (rates) memset(w->cross_rate + rates*(size_t)k, 0, rates*sizeof(dem_real));
}
/* Clears the slots of all pairs of bodies that may have persistent contacts. */
static void demi_persistent_clear(dem_world *w, int d) {
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
