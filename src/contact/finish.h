/* ---------------------------------------------------------------------------------------------
   >>finish
   What the contacts of a tile give once their forces are known: to both bodies, to walls, to the
   ledger, to user-defined numbers, to a cell that deforms, and to events. A contact with a body of
   a later work group stores the force on that body in a slot; the other work group adds it once all
   are done, in list order. The order of every sum is thus independent of the number of threads.
   Writes forces and rates of bodies, slots, sums of walls and of work groups, `force` of persistent
   contacts, and notes.
   --------------------------------------------------------------------------------------------- */

/* Corrects the energy that dashpots took to the velocities of the actual path. */
static void demi_tile_late(const dem_world *w, const demi_span *span, int full,
                           demi_tile *DEMI_RESTRICT t) {
    const dem_real *DEMI_RESTRICT late = w->bodies.late, wall[3] = {0, 0, 0};
    int n;
    for (n = 0; n < span->count; n++)
        demi_rows_minus(&t->late, (size_t)n, DEMI_AT(late, span->a[n]),
                        span->b[n] < 0 ? wall : DEMI_AT(late, span->b[n]));
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
    if (r->parting) demi_scatter(t, span, force, torque, 1, 1);
    else if (r->turning) demi_scatter(t, span, force, torque, 1, 0);
    else demi_scatter(t, span, force, torque, 0, 0);
}
/* The same for pairs with later work groups: forces on b stay in slots `out`, six reals for each
   candidate. */
static void demi_tile_send(demi_tile *DEMI_RESTRICT t, const demi_span *span,
                               const demi_run *r, dem_real *DEMI_RESTRICT force,
                               dem_real *DEMI_RESTRICT torque, dem_real *DEMI_RESTRICT slots) {
    int q;
    for (q = 0; q < span->count; q++) {
        dem_real *out = slots + 6*(size_t)span->k[q];
        const dem_vec3 f = demi_row(t->force, q);
        demi_force_add(DEMI_AT(force, span->a[q]), f);
        if (r->turning) demi_force_add(DEMI_AT(torque, span->a[q]), demi_row(t->torque[0], q));
        out[0] = -f.x; out[1] = -f.y; out[2] = -f.z;
        if (r->turning) demi_put(out + 3, demi_row(t->torque[r->parting], q));
    }
}

/* Adds the rates that a law returned for user-defined numbers, by the weights of the contacts, to
   both bodies or to their slots or walls. send: as in demi_tile_finish. */
static DEMI_APART void demi_tile_rates(const demi_tile *t, const demi_span *span, dem_world *w,
                                       int d, int send) {
    const int n = w->bodies.real_count, all = !span->points;
    int q, k;
    for (q = 0; q < span->count; q++) {
        const int i = span->b[q], touch = t->touch[q] > 0;
        const int sends = all ? send : span->k[q] >= 0, sets = sends && all;
        const dem_real share = all ? 1 : span->points->share[q];
        dem_real *a = w->bodies.rates + n*span->a[q];
        dem_real *b = sends ? w->cross_rate + (size_t)n*(size_t)span->k[q]
            : w->bodies.rates + n*DEMI_MAX(i, 0);
        double *wall = i >= 0 ? 0 : w->wall_rates +
            (size_t)n*((size_t)d*(size_t)w->wall_count + (size_t)(-1 - i));
        for (k = 0; k < n; k++) {
            const dem_real gain = touch ? share*t->gains[q][DEM_BODY_REALS + k] : 0;
            if (touch) a[k] += share*t->gains[q][k];
            if (i < 0) wall[k] += (double)gain;
            else if (sets) b[k] = gain;
            else if (touch) b[k] += gain;
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
/* The same for all contacts of a tile between bodies. */
static DEMI_APART void demi_tile_cells(const dem_world *w, const demi_tile *t,
                                       const demi_span *span, double *sum) {
    const demi_points *p = span->points;
    int q;
    for (q = 0; q < span->count; q++)
        if (t->touch[q] > 0 && span->b[q] >= 0)
            demi_tile_cell(w, t, q, !p ? demi_rows_at(&t->gap, q)
                           : demi_sub(demi_rows_at(&p->arm[0], q), demi_rows_at(&p->arm[1], q)),
                           p ? p->slope[q]*(p->lift[q] + p->share[q]) : 1, sum);
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
/* Returns the force of row q on a, and sets *moment, as its wall has them: with its own pressure,
   while a has its part of all (demi_persistent_more). The sums over all parts are equal. */
DEM_INLINE dem_vec3 demi_point_own(const demi_points *t, int q, dem_vec3 *moment) {
    const demi_persistent *c = t->contact[q];
    const dem_vec3 force = demi_v(t->rows.force[0][q], t->rows.force[1][q], t->rows.force[2][q]);
    *moment = demi_v(t->rows.moment[0][q], t->rows.moment[1][q], t->rows.moment[2][q]);
    if (!c->odd || !(c->more.part > 0)) return force;
    *moment = demi_sub(*moment, demi_scale(c->more.turn, t->rows.repulsion[q]));
    return demi_sub(force, demi_scale(c->more.lean, t->rows.repulsion[q]));
}
/* Adds the force of row q to the sums of its wall. */
static void demi_point_wall(dem_world *w, int d, demi_points *t, int q) {
    const int i = -1 - t->b[q];
    const demi_wall *wall = &w->walls[i];
    demi_wall_sum *sum = &w->wall_sums[(size_t)d*(size_t)w->wall_count + (size_t)i];
    demi_persistent *c = t->contact[q];
    dem_vec3 moment, rubs = demi_row(t->rows.force, q);
    c->force = demi_point_own(t, q, &moment);
    demi_wall_sum_add(w, sum, i, t->at[q], c->force, moment, t->surface[q]);
    if (!wall->glides) return;
    if (t->raised[q] == 2) rubs = demi_sub(rubs, demi_scale(t->aside[q], t->still[q]));
    /* only friction does work on a gliding surface */
    sum->power += (double)demi_dot(rubs, demi_glide_at(wall, &wall->pose, c->normal));
}
/* Adds the forces of a tile to both bodies, to body a and the slot of b (several contacts may share
   one), or to body a and its wall. */
static void demi_points_push(dem_world *w, int d, demi_points *t) {
    const int turns = demi_turns(w);            /* else nothing sets torques to 0 in a step */
    int q;
    for (q = 0; q < t->count; q++) {
        const int a = t->a[q], b = t->b[q];
        dem_real *out = t->k[q] < 0 ? 0 : w->cross_force + 6*(size_t)t->k[q];
        const dem_vec3 force = demi_row(t->rows.force, q);
        demi_force_add(w->bodies.force + 4*a, force);
        if (turns) demi_force_add(w->bodies.torque + 4*a, demi_row(t->rows.torque[0], q));
        if (b < 0) { demi_point_wall(w, d, t, q); continue; }
        if (t->contact[q]) t->contact[q]->force = force;
        demi_force_add(out ? out : w->bodies.force + 4*b, demi_scale(force, -1));
        demi_force_add(out ? out + 3 : w->bodies.torque + 4*b, demi_row(t->rows.torque[1], q));
    }
}
/* Adds what the contacts of a tile give to bodies or walls, to the ledger, to user-defined numbers,
   to a cell that deforms and to events. send: 1 if the bodies b of lone spheres are of later work
   groups, so that forces on them go to slots; 0 in a tile of >>points, where each row tells. */
static void demi_tile_finish(dem_world *w, int d, demi_tile *t, const demi_span *span,
                             const demi_run *r, int send) {
    const int full = (span->count + DEMI_LANES - 1)/DEMI_LANES*DEMI_LANES;
    demi_domain *domain = &w->domains[d];
    if (r->ledger && w->bodies.booked) demi_tile_late(w, span, full, t);
    if (r->ledger) demi_tile_book(t, span->count, domain->energy);
    if (span->points) demi_points_push(w, d, span->points);
    else if (!send) demi_tile_scatter(t, span, r, w->bodies.force, w->bodies.torque);
    else demi_tile_send(t, span, r, w->bodies.force, w->bodies.torque, w->cross_force);
    if (demi_exchanges(w)) demi_tile_rates(t, span, w, d, send);
    if (w->cell.on) demi_tile_cells(w, t, span, domain->cell);
    if (w->events.n.on) demi_tile_note(w, d, t, span, r);
}
