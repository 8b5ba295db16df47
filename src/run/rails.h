/* ---------------------------------------------------------------------------------------------
   >>rails
   Bodies whose axes are locked (dem_body_rail_set). When all forces of a step are known, the
   reaction of each rail is added to the force and torque of its body. It is such that the next kick
   gives the prescribed velocity in the middle of the next step along locked axes, whatever the
   integrator. Owns the rails; adds to forces and torques of bodies, and rotates bodies that are not
   spheres about free axes.
   Translation and spheres: r = m (v - u)/h - f - m g, where u is the velocity of the last half
   step, v that of the next one and h their distance in time. Other shapes: the spin w of the next
   step obeys w = prescribed along locked axes and (J w) = L + T h along free ones, with the inertia
   J of the middle of that step. The body then rotates with w for the whole step, so the axis does
   not wander: its own free rotation would also turn about locked axes.
   The velocity of a wall in the middle of the next step is extrapolated, 2 v(t) - v(t - dt/2). The
   error of the path is of the order dt^2 and does not grow.
   --------------------------------------------------------------------------------------------- */
#define DEMI_OF dem_rail_desc
static const demi_field_row demi_rail_fields[] = {
    DEMI_LIMITED(DEMI_OF, axes, 'i', DEMI_FROM, DEM_RAIL_ALL, ""),
    DEMI_LIMITED(DEMI_OF, velocity, 'v', DEMI_ANY, DEMI_FARTHEST, "m/s"),
    DEMI_LIMITED(DEMI_OF, spin, 'v', DEMI_ANY, DEMI_FARTHEST, "rad/s"),
    DEMI_ROW(DEMI_OF, wall, 'i'), DEMI_ROW_END};
#undef DEMI_OF
/* Returns the index of the body of a rail; -1 if it was removed or is fixed. */
static int demi_rail_body(const dem_world *w, const demi_rail *r) {
    const uint32_t slot = r->body.slot - 1;
    const int i = w->bodies.slot_generation[slot] == r->body.generation
        ? w->bodies.slot_index[slot] : -1;
    return i >= 0 && w->bodies.inv_mass[i] > 0 ? i : -1;
}
/* The position of body i, with a rail, as if its path had crossed no periodic face, m. */
static dem_vec3 demi_rail_place(const dem_world *w, const demi_rail *r, int i) {
    const demi_periods p = demi_periods_of(w);
    return demi_add(r->at, demi_nearest(&p, demi_sub(demi_at(w->bodies.pos + 4*i), r->at)));
}
/* Between two steps only dem_body_set moves a body. The coordinates that it has changed count as
   given, not as those of an image across a periodic face. */
static void demi_rail_given(const dem_world *w, demi_rail *r, int i) {
    const demi_periods p = demi_periods_of(w);
    const dem_vec3 x = demi_at(w->bodies.pos + 4*i);
    dem_real by[3], now[3], at[3];
    int k;
    demi_put(by, demi_nearest(&p, demi_sub(x, r->seen)));
    demi_put(now, x);
    demi_put(at, demi_rail_place(w, r, i));
    for (k = 0; k < 3; k++)                     /* wrapping leaves a rounding error */
        if (DEMI_ABS(by[k]) > DEM_R(1e-6)*w->bodies.pos[4*i + 3]) at[k] = now[k];
    r->at = demi_at(at);
}
/* Gives the velocity and spin that a rail prescribes for body i, in the middle of the next step
   (ahead) or now; of axes that are not locked, any numbers. */
static void demi_rail_wants(const dem_world *w, const demi_rail *r, int i, int ahead, dem_real *v,
                            dem_real *s) {
    const dem_rail_desc *d = &r->state.desc;
    dem_vec3 velocity = d->velocity, spin = d->spin;
    if (d->wall.id && demi_wall_there(w, d->wall)) {
        const demi_wall *wall = &w->walls[demi_wall_place(d->wall)];
        const dem_vec3 x = demi_rail_place(w, r, i);
        const dem_vec3 now = demi_surface_at(&wall->pose, x);
        velocity = demi_add(velocity, now);
        spin = demi_add(spin, wall->pose.spin);
        if (ahead) {                            /* x in the middle of the last step */
            const dem_vec3 mid = demi_sub(x, demi_scale(demi_at(w->bodies.half_vel + 4*i),
                                                        w->clock.dt/2));
            velocity = demi_add(velocity, demi_sub(now, demi_surface_at(&wall->mid, mid)));
            spin = demi_add(spin, demi_sub(wall->pose.spin, wall->mid.spin));
        }
    }
    demi_put(v, velocity);
    demi_put(s, spin);
}
/* Returns J x for a body with orientation q and principal moments I. */
static dem_vec3 demi_inertia_times(dem_quat q, dem_vec3 I, dem_vec3 x) {
    const dem_vec3 m = dem_quat_unrotate(q, x);
    return dem_quat_rotate(q, demi_v(I.x*m.x, I.y*m.y, I.z*m.z));
}
/* Solves for the spin w of the next step of a body that is not a sphere, see above. L: its angular
   momentum without reaction; locked: bit k: w_k is want[k]. Returns J w. */
static dem_vec3 demi_rail_turn(const dem_world *w, int i, int locked, const dem_real *want,
                               dem_vec3 L, dem_vec3 *spin) {
    const dem_quat q = demi_quat_at(w->bodies.orient + 4*i);
    const dem_vec3 I = demi_at(w->bodies.moment + 4*i);
    const dem_real h = w->clock.dt/2;
    dem_quat mid = q;
    int pass, k;
    for (pass = 0; pass < 3; pass++) {
        dem_vec3 row[3], c[3];
        dem_real b[3], det;
        demi_put(b, L);
        for (k = 0; k < 3; k++) {
            const dem_vec3 e = demi_v(k == 0, k == 1, k == 2);
            row[k] = locked >> k & 1 ? e : demi_inertia_times(mid, I, e);     /* J = J^T */
            if (locked >> k & 1) b[k] = want[k];
            else {                              /* rows of like size */
                row[k] = demi_scale(row[k], 1/I.x);
                b[k] /= I.x;
            }
        }
        for (k = 0; k < 3; k++) c[k] = demi_cross(row[(k + 1)%3], row[(k + 2)%3]);
        det = demi_dot(row[0], c[0]);
        *spin = demi_scale(demi_add(demi_scale(c[0], b[0]), demi_add(demi_scale(c[1], b[1]),
                                    demi_scale(c[2], b[2]))), 1/det);
        mid = demi_quat_again(dem_quat_multiply(demi_quat_exp(demi_scale(*spin, h)), q));
    }
    return demi_inertia_times(mid, I, *spin);
}
/* Adds the reaction along three locked axes to f, and to the force r of the rail. inertia: mass, or
   moment of inertia; g: acceleration besides forces. Returns the power at the mean of u and v,
   W. */
static double demi_rail_push(int locked, dem_real inertia, const dem_real *u, const dem_real *v,
                             dem_real h, const dem_real *g, dem_real *f, dem_real *r) {
    double power = 0;
    int k;
    for (k = 0; k < 3; k++) {
        r[k] = 0;
        if (!(locked >> k & 1)) continue;
        r[k] = inertia*((v[k] - u[k])/h - g[k]) - f[k];
        f[k] += r[k];
        power += (double)r[k]*(double)(u[k] + v[k])/2;
    }
    return power;
}
/* Adds the reaction of one rail to its body i. */
static void demi_rail_act(dem_world *w, demi_rail *r, int i) {
    const int stepping = w->stage.forces_valid, locked = r->state.desc.axes;
    const int halves = stepping && demi_integrator_of(w)->predicts;
    const dem_real h = stepping ? w->clock.dt : w->clock.dt/2;
    const demi_lane b = demi_lane_move(w, i);
    dem_real *torque = w->bodies.torque + 4*i, v[3], s[3], force[3], moment[3];
    const dem_real none[3] = {0, 0, 0};
    const dem_real *spun = stepping && (halves || demi_shape_of(w, i)) ? w->bodies.half_spin + 4*i
        : w->bodies.spin + 4*i;
    if (!stepping) demi_rail_given(w, r, i);
    demi_rail_wants(w, r, i, 1, v, s);
    r->at = demi_rail_place(w, r, i);
    r->seen = demi_at(w->bodies.pos + 4*i);
    r->state.power = demi_rail_push(locked, w->bodies.mass[i], halves ? b.half : b.v, v, h, b.g,
                                    b.f, force);
    if (demi_shape_of(w, i) && locked >> 3) {
        const dem_vec3 L = stepping ? demi_at(w->bodies.angular + 4*i) : demi_angular_of(w, i);
        const dem_vec3 T = demi_at(torque);
        const dem_vec3 next = demi_rail_turn(w, i, locked >> 3, s, demi_add(L, demi_scale(T, h)),
                                             &r->turn);
        dem_real by[3];
        int k;
        demi_put(by, demi_sub(demi_scale(demi_sub(next, L), 1/h), T));
        demi_put(s, r->turn);
        for (k = 0; k < 3; k++) {
            moment[k] = locked >> (3 + k) & 1 ? by[k] : 0;
            torque[k] += moment[k];
            r->state.power += (double)moment[k]*(double)(spun[k] + s[k])/2;
        }
        r->start = demi_quat_at(w->bodies.orient + 4*i);
    } else
        r->state.power += demi_rail_push(locked >> 3, w->bodies.inv_inertia[i] > 0
                                         ? 1/w->bodies.inv_inertia[i] : 0, spun, s, h, none,
                                         torque, moment);
    r->state.force = demi_at(force);
    r->state.torque = demi_at(moment);
    if (!stepping) return;
    r->state.work += r->state.power*(double)w->clock.dt;
    if (!w->desc.ledger) return;
    w->booked.energy[DEMI_E_WALLS] += r->state.power*(double)w->clock.dt;
    w->booked.throughput += fabs(r->state.power)*(double)w->clock.dt;
}
/* Adds the reactions of all rails, once all forces are known. */
static void demi_rails_act(dem_world *w) {
    int k;
    for (k = 0; k < w->rail_count && w->clock.dt > 0; k++) {
        const int i = demi_rail_body(w, &w->rails[k]);
        dem_rail_state *state = &w->rails[k].state;
        if (i >= 0) demi_rail_act(w, &w->rails[k], i);
        else {
            state->force = state->torque = demi_v(0, 0, 0);
            state->power = 0;
        }
    }
}
/* After the move of a step: rotates bodies that are not spheres about free axes alone. */
static void demi_rails_move(dem_world *w) {
    const dem_real dt = w->clock.dt;
    int k, e;
    for (k = 0; k < w->rail_count; k++) {
        const demi_rail *r = &w->rails[k];
        const int i = demi_rail_body(w, r), locked = r->state.desc.axes >> 3;
        const demi_shape *shape = i < 0 ? 0 : demi_shape_of(w, i);
        dem_quat q;
        dem_vec3 I;
        dem_real spin[3], turn[3];
        if (!shape || !locked) continue;
        q = demi_quat_again(dem_quat_multiply(demi_quat_exp(demi_scale(r->turn, dt)), r->start));
        I = demi_at(w->bodies.moment + 4*i);
        demi_quat_put(w->bodies.orient + 4*i, q);
        demi_put(spin, demi_spin_of(q, demi_add(demi_at(w->bodies.angular + 4*i),
            demi_scale(demi_at(w->bodies.torque + 4*i), dt/2)), demi_v(1/I.x, 1/I.y, 1/I.z)));
        demi_put(turn, r->turn);
        for (e = 0; e < 3; e++) {
            w->bodies.half_spin[4*i + e] = turn[e];
            w->bodies.spin[4*i + e] = locked >> e & 1 ? turn[e] : spin[e];
        }
        if (w->bodies.centres_valid) demi_centres_rotate(w, &i, 1);
    }
}
/* Returns the number of rails whose bodies still exist. */
static int demi_rails_in_force(const dem_world *w) {
    int k, n = 0;
    for (k = 0; k < w->rail_count; k++) n += demi_joint_body(w, w->rails[k].body) >= 0;
    return n;
}
/* Removes the rails of bodies that were removed, and that of `body`. */
static void demi_rails_drop(dem_world *w, dem_body body) {
    int k, left = 0;
    for (k = 0; k < w->rail_count; k++) {
        const dem_body b = w->rails[k].body;
        if (w->bodies.slot_generation[b.slot - 1] == b.generation &&
            (b.slot != body.slot || b.generation != body.generation))
            w->rails[left++] = w->rails[k];
    }
    w->rail_count = left;
}
DEM_API dem_result dem_body_rail_set(dem_world *w, dem_body body, const dem_rail_desc *d) {
    dem_real v[3], s[3], own[6];
    dem_body_state state;
    demi_rail *r;
    int i, k;
    if (demi_null(w, __func__, d, "desc")) return DEM_ERROR_ARGUMENT;
    i = demi_body_index(w, __func__, body);
    if (i < 0 || demi_rows_check(w, __func__, demi_rail_fields, d, "", "start from DEM_RAIL_DESC"))
        return DEM_ERROR_ARGUMENT;
    if (!demi_response_is(w, DEMI_LASTING))
        return demi_refuse(w, __func__, "contacts of this world are impulses, whose solver has one "
                           "mass per body for all axes; use DEM_RESPONSE_SPRINGS, or joints "
                           "(dem_joint_add)");
    if (w->bodies.inv_mass[i] <= 0)
        return demi_refuse(w, __func__, "body %u is fixed, so all its axes are locked; set `fixed` "
                           "to 0 with dem_body_set", (unsigned)body.slot);
    if (w->desc.planar && d->axes & (DEM_RAIL_Z | DEM_RAIL_SPIN_X | DEM_RAIL_SPIN_Y))
        return demi_refuse(w, __func__, "axes is %d, but a planar world locks Z, SPIN_X and SPIN_Y "
                           "of all bodies; leave them out", d->axes);
    if ((d->wall.id && demi_wall_find(w, __func__, d->wall) < 0) ||
        (d->axes && w->cell.on && demi_cell_bars(w, __func__, DEMI_CELL_RAILS)))
        return DEM_ERROR_ARGUMENT;
    if (!DEMI_GROW(w, w->rails, (size_t)w->rail_count + 1)) return demi_no_memory(w, __func__);
    demi_rails_drop(w, body);
    if (!d->axes) { demi_scene_changed(w); return DEM_OK; }
    r = &w->rails[w->rail_count];
    memset(r, 0, sizeof *r);
    r->body = body;
    r->state.desc = *d;
    r->at = r->seen = demi_at(w->bodies.pos + 4*i);
    demi_rail_wants(w, r, i, 0, v, s);
    dem_body_get(w, body, &state);
    demi_put(own, state.velocity);
    demi_put(own + 3, state.spin);
    for (k = 0; k < 6; k++) if (d->axes >> k & 1) own[k] = k < 3 ? v[k] : s[k - 3];
    state.velocity = demi_at(own);
    state.spin = demi_at(own + 3);
    if (dem_body_set(w, body, &state) != DEM_OK) return demi_no_memory(w, __func__);
    w->rail_count++;
    return DEM_OK;
}
DEM_API dem_result dem_body_reaction_get(const dem_world *w, dem_body body, dem_rail_state *state) {
    const demi_rail *r;
    if (demi_null_look(w, __func__, state, "state")) return DEM_ERROR_ARGUMENT;
    if (demi_body_index((dem_world *)w, __func__, body) < 0) return DEM_ERROR_ARGUMENT;
    r = demi_rail_of(w, body);
    if (!r)
        return demi_refuse(w, __func__, "body %u has no rail; set one with dem_body_rail_set",
                           (unsigned)body.slot);
    *state = r->state;
    return DEM_OK;
}
