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
   A rail of a wall. The body is carried by the rigid motion of the wall between its two poses, so
   its path along locked axes is that of a point of the wall, for any step and integrator. Motion
   relative to the wall, with the velocity of the rail and along free axes, is split: half before
   the wall moves, half after. Velocities are those of the surface: v in the middle of the step,
   or at its end with integrators that have no half kick, and the predicted one at its end. The
   poses of the next step are known before it, except of servo walls, whose speed is taken as
   constant; demi_rails_carry books what the change of their speed adds.
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
        if (DEMI_ABS(by[k]) > DEM_R(1e-6)*demi_radius(w, i)) at[k] = now[k];
    r->at = demi_at(at);
}
/* Returns the index of the wall that a rail follows; -1 if there is none. */
static int demi_rail_wall(const dem_world *w, const demi_rail *r) {
    const dem_wall wall = r->state.desc.wall;
    return wall.id && demi_wall_there(w, wall) ? demi_wall_place(wall) : -1;
}
/* Gives the velocity and spin that a rail prescribes at x in a pose of its wall, or without a wall
   (pose null); of axes that are not locked, any numbers. */
static void demi_rail_wants(const demi_rail *r, const dem_pose *pose, dem_vec3 x, dem_real *v,
                            dem_real *s) {
    const dem_rail_desc *d = &r->state.desc;
    demi_put(v, pose ? demi_add(d->velocity, demi_surface_at(pose, x)) : d->velocity);
    demi_put(s, pose ? demi_add(d->spin, pose->spin) : d->spin);
}
/* Returns by how much a body moves relative to its wall in a step, m. v: its mean velocity along
   free axes. */
static dem_vec3 demi_rail_strays(const dem_world *w, const demi_rail *r, const dem_pose *from,
                                 const dem_real *v) {
    dem_real by[3], flow[3];
    int k;
    demi_put(by, r->state.desc.velocity);
    demi_put(flow, demi_surface_at(from, r->at));
    for (k = 0; k < 3; k++) if (!(r->state.desc.axes >> k & 1)) by[k] = v[k] - flow[k];
    return demi_scale(demi_at(by), w->clock.dt);
}
/* Returns where a body is after `part` of a step, 1/2 or 1, in which its wall moves from one pose
   to another, m. gone: see demi_rail_strays. */
static dem_vec3 demi_rail_ride(const demi_rail *r, dem_vec3 gone, const dem_pose *from,
                               const dem_pose *to, dem_real part) {
    const dem_vec3 half = demi_unrotate(from->rotation, demi_scale(gone, DEM_R(0.5)));
    return demi_add(demi_add(to->position, demi_rotate(to->rotation, demi_add(r->on, half))),
                    demi_scale(gone, part - DEM_R(0.5)));
}
/* Gives the velocity and spin that a rail will prescribe for body i in the next step. drift: its
   mean velocity then along free axes. */
static void demi_rail_ahead(const dem_world *w, const demi_rail *r, int i, const dem_real *drift,
                            dem_real *v, dem_real *s) {
    const int of = demi_rail_wall(w, r), halves = demi_integrator_of(w)->predicts;
    const demi_wall *wall = of < 0 ? 0 : &w->walls[of];
    dem_pose ahead;
    if (!wall) { demi_rail_wants(r, 0, r->at, v, s); return; }
    ahead = wall->pose;
    if (wall->motion.kind != DEM_MOTION_FIXED)
        demi_wall_pose_at(w, wall, w->clock.time + (double)w->clock.dt/(halves ? 2 : 1), &ahead);
    if (!demi_pose_sane(&ahead)) ahead = wall->pose;        /* the step will fail */
    demi_rail_wants(r, &ahead, demi_rail_ride(
        r, demi_rail_strays(w, r, &wall->pose, drift), &wall->pose, &ahead,
        halves ? DEM_R(0.5) : 1), v, s);
    if (!halves && demi_shape_of(w, i))                     /* these rotate with the mean spin */
        demi_put(s, demi_add(demi_at(s), demi_scale(demi_sub(wall->pose.spin, ahead.spin),
                                                    DEM_R(0.5))));
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
/* Adds work to that of a rail, J. */
static void demi_rail_book(dem_world *w, demi_rail *r, double work) {
    r->state.work += work;
    if (w->desc.ledger) demi_work_book(w, DEMI_E_WALLS, work);
}
/* Adds the reaction of one rail to its body i. */
static void demi_rail_act(dem_world *w, demi_rail *r, int i) {
    const int stepping = w->stage.forces_valid, locked = r->state.desc.axes;
    const int predicts = demi_integrator_of(w)->predicts, halves = stepping && predicts;
    const dem_real h = stepping ? w->clock.dt : w->clock.dt/2;
    const dem_real kick = predicts ? h : w->clock.dt;       /* of the next step */
    const demi_lane b = demi_lane_move(w, i);
    dem_real *torque = w->bodies.torque + 4*i, *u = halves ? b.half : b.v;
    dem_real v[3], s[3], force[3], moment[3];
    const dem_real none[3] = {0, 0, 0};
    const dem_real *spun = stepping && (halves || demi_shape_of(w, i)) ? w->bodies.half_spin + 4*i
        : w->bodies.spin + 4*i;
    int k, of;
    if (!stepping) demi_rail_given(w, r, i);
    r->at = demi_rail_place(w, r, i);
    r->seen = demi_at(w->bodies.pos + 4*i);
    of = demi_rail_wall(w, r);
    if (of >= 0 && (!stepping || w->walls[of].motion.kind == DEM_MOTION_FIXED))
        r->on = demi_unrotate(w->walls[of].pose.rotation,
                              demi_sub(r->at, w->walls[of].pose.position));
    if (w->bodies.orienting) r->start = demi_quat_at(w->bodies.orient + 4*i);
    for (k = 0; k < 3; k++) v[k] = u[k] + (b.f[k]*b.inv + b.g[k])*kick;
    demi_rail_ahead(w, r, i, v, v, s);
    r->state.power = demi_rail_push(locked, w->bodies.mass[i], u, v, kick, b.g, b.f, force);
    if (demi_shape_of(w, i) && locked >> 3) {
        const dem_vec3 L = stepping ? demi_at(w->bodies.angular + 4*i) : demi_angular_of(w, i);
        const dem_vec3 T = demi_at(torque);
        const dem_vec3 next = demi_rail_turn(w, i, locked >> 3, s, demi_add(L, demi_scale(T, h)),
                                             &r->turn);
        dem_real by[3];
        demi_put(by, demi_sub(demi_scale(demi_sub(next, L), 1/h), T));
        demi_put(s, r->turn);
        for (k = 0; k < 3; k++) {
            moment[k] = locked >> (3 + k) & 1 ? by[k] : 0;
            torque[k] += moment[k];
            r->state.power += (double)moment[k]*(double)(spun[k] + s[k])/2;
        }
    } else
        r->state.power += demi_rail_push(locked >> 3, w->bodies.inv_inertia[i] > 0
                                         ? 1/w->bodies.inv_inertia[i] : 0, spun, s, kick, none,
                                         torque, moment);
    r->state.force = demi_at(force);
    r->state.torque = demi_at(moment);
    if (!stepping) return;
    demi_rail_book(w, r, r->state.power*(double)w->clock.dt);
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
/* Rotates body i from its orientation at the start of the step by the vector `by`, rad. full: its
   spin at the end, along locked axes. */
static void demi_rail_rotate(dem_world *w, const demi_rail *r, int i, const dem_real *by,
                             const dem_real *full) {
    const dem_quat q = demi_quat_again(dem_quat_multiply(demi_quat_exp(demi_at(by)), r->start));
    const dem_vec3 I = demi_at(w->bodies.moment + 4*i);
    const int shaped = demi_shape_of(w, i) != 0;
    dem_real spin[3], turn[3];
    int e;
    demi_quat_put(w->bodies.orient + 4*i, q);
    if (shaped)
        demi_put(spin, demi_spin_of(q, demi_add(demi_at(w->bodies.angular + 4*i),
            demi_scale(demi_at(w->bodies.torque + 4*i), w->clock.dt/2)),
            demi_v(1/I.x, 1/I.y, 1/I.z)));
    demi_put(turn, r->turn);
    for (e = 0; e < 3; e++) {
        if (shaped) w->bodies.half_spin[4*i + e] = turn[e];
        if (r->state.desc.axes >> (3 + e) & 1) w->bodies.spin[4*i + e] = full[e];
        else if (shaped) w->bodies.spin[4*i + e] = spin[e];
    }
    if (w->bodies.centres_valid) demi_centres_rotate(w, &i, 1);
}
/* After the move of a step: rotates bodies that are not spheres about free axes alone. */
static void demi_rails_move(dem_world *w) {
    int k;
    for (k = 0; k < w->rail_count; k++) {
        const demi_rail *r = &w->rails[k];
        const int i = demi_rail_body(w, r);
        dem_real by[3], turn[3];
        if (i < 0 || !demi_shape_of(w, i) || !(r->state.desc.axes >> 3)) continue;
        demi_put(by, demi_scale(r->turn, w->clock.dt));
        demi_put(turn, r->turn);
        demi_rail_rotate(w, r, i, by, turn);
    }
}
/* Returns the rotation from one pose to another as a vector, rad. */
static dem_vec3 demi_pose_turned(const dem_pose *from, const dem_pose *to) {
    double R[3][3], size, angle;
    dem_quat q;
    int i, j;
    for (i = 0; i < 3; i++)
        for (j = 0; j < 3; j++)
            R[i][j] = (double)demi_dot(demi_at(to->rotation + 3*i), demi_at(from->rotation + 3*j));
    q = demi_quat_of(R);
    size = sqrt((double)(q.x*q.x + q.y*q.y + q.z*q.z));
    angle = 2*demi_atan2(size, fabs((double)q.w));
    return demi_scale(demi_v(q.x, q.y, q.z),
                      (dem_real)(size > 0 ? (q.w < 0 ? -angle : angle)/size : 0));
}
/* Carries body i with its wall, which moves from one pose by another in the middle of the step to a
   third. Returns the change of its mean velocity, m/s. */
static dem_real demi_rail_carry(dem_world *w, demi_rail *r, int i, const dem_pose *from,
                                const dem_pose *mid, const dem_pose *to) {
    const int locked = r->state.desc.axes, halves = demi_integrator_of(w)->predicts;
    const demi_periods p = demi_periods_of(w);
    const dem_vec3 off = demi_sub(r->at, r->seen), wrapped = demi_sub(off, demi_nearest(&p, off));
    const dem_vec3 own = demi_scale(r->state.desc.spin, w->clock.dt);
    const dem_vec3 gone = demi_rail_strays(w, r, from, w->bodies.half_vel + 4*i);
    const dem_vec3 after = demi_scale(gone, DEM_R(0.5)), end = demi_rail_ride(r, gone, from, to, 1);
    dem_real *half = w->bodies.half_vel + 4*i, *full = w->bodies.vel + 4*i;
    dem_real x[3], free[3], stray[3], m[3], v[3], s[3], force[3], by[3], most = 0;
    double work = 0;
    int k;
    demi_rail_wants(r, mid, demi_rail_ride(r, gone, from, mid, DEM_R(0.5)), m, s);
    demi_rail_wants(r, to, end, v, s);
    demi_put(x, demi_sub(end, wrapped));
    demi_put(free, demi_sub(demi_add(r->at, demi_scale(demi_at(half), w->clock.dt)),
                            demi_sub(end, after)));
    demi_put(stray, after);
    demi_put(by, demi_add(demi_pose_turned(from, to), own));
    demi_put(force, r->state.force);
    for (k = 0; k < 3; k++) {
        const dem_real was = halves ? half[k] : full[k], now = halves ? m[k] : v[k];
        if (!(locked >> (3 + k) & 1)) by[k] = w->bodies.half_spin[4*i + k]*w->clock.dt;
        if (!(locked >> k & 1)) { stray[k] = free[k]; continue; }
        work += (double)((now - was)*(w->bodies.mass[i]*(was + now) + force[k]*w->clock.dt))/2;
        most = DEMI_MAX(most, DEMI_ABS(m[k] - half[k]));
        w->bodies.pos[4*i + k] = x[k];
        half[k] = m[k];
        full[k] = v[k];
    }
    r->on = demi_add(r->on, demi_add(demi_unrotate(from->rotation, after),
                                     demi_unrotate(to->rotation, demi_at(stray))));
    demi_rail_book(w, r, work);
    if (locked >> 3 && (demi_shape_of(w, i) || w->desc.orientations))
        demi_rail_rotate(w, r, i, by, s);
    else for (k = 0; k < 3; k++) if (locked >> (3 + k) & 1) w->bodies.spin[4*i + k] = s[k];
    return most;
}
/* Carries all bodies on rails of wall `of`. */
static void demi_rails_carry(dem_world *w, int of, const dem_pose *mid, const dem_pose *to) {
    dem_real most = 0;
    int k;
    for (k = 0; k < w->rail_count; k++) {
        demi_rail *r = &w->rails[k];
        const int i = demi_rail_wall(w, r) == of ? demi_rail_body(w, r) : -1;
        dem_real change = 0;
        if (i >= 0) change = demi_rail_carry(w, r, i, &w->walls[of].pose, mid, to);
        most = DEMI_MAX(most, change);
    }
    w->margin.step_gone += (double)(most*w->clock.dt);
    w->margin.last_change += (double)most;
}
/* Returns the number of rails whose bodies still exist. */
static int demi_rails_in_force(const dem_world *w) {
    int k, n = 0;
    for (k = 0; k < w->rail_count; k++) n += demi_body_find(w, w->rails[k].body) >= 0;
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
/* Gives a body the velocity and spin that its rail prescribes. Returns 0 if memory runs out. */
static int demi_rail_lead(dem_world *w, demi_rail *r) {
    const int of = demi_rail_wall(w, r), axes = r->state.desc.axes;
    dem_real v[3], s[3], own[6];
    dem_body_state state;
    int k, ok;
    demi_rail_wants(r, of < 0 ? 0 : &w->walls[of].pose, r->at, v, s);
    dem_body_get(w, r->body, &state);
    demi_put(own, state.velocity);
    demi_put(own + 3, state.spin);
    for (k = 0; k < 6; k++) if (axes >> k & 1) own[k] = k < 3 ? v[k] : s[k - 3];
    state.velocity = demi_at(own);
    state.spin = demi_at(own + 3);
    r->state.desc.axes = 0;                     /* dem_body_set leaves locked axes as they are */
    ok = dem_body_set(w, r->body, &state) == DEM_OK;
    r->state.desc.axes = axes;
    return ok;
}
/* A wall with a new motion takes its bodies along at once. Returns 0 if memory runs out. */
static int demi_rails_lead(dem_world *w, int wall) {
    int k, ok = 1;
    for (k = 0; k < w->rail_count && ok; k++)
        if (demi_rail_wall(w, &w->rails[k]) == wall && demi_rail_body(w, &w->rails[k]) >= 0)
            ok = demi_rail_lead(w, &w->rails[k]);
    return ok;
}
DEM_API dem_result dem_body_rail_set(dem_world *w, dem_body body, const dem_rail_desc *d) {
    demi_rail *r;
    int i;
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
    if (!demi_rail_lead(w, r)) return demi_no_memory(w, __func__);
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
static int demi_rails_on(const dem_world *w) { return w->rail_count > 0; }
/* --- rails in a checkpoint, see >>features. They are state, as joints are. --- */

static void demi_rails_visit(dem_world *w, demi_stream *s) {
    if (w->rail_count) demi_visit(s, w->rails, (size_t)w->rail_count*sizeof(demi_rail));
}
static int demi_rails_grow(dem_world *t) {
    return DEMI_GROW(t, t->rails, (size_t)t->rail_count);
}
static int demi_rails_counts(const demi_reader *r) {
    const dem_world *t = r->t, *w = r->w;
    if (!demi_left(r, t->rail_count, sizeof(demi_rail)) ||
        (t->rail_count && !demi_response_is(w, DEMI_LASTING)))
        return demi_lie(r, "number of rails", -1);
    return 1;
}
/* Checks rails: bodies must be slots, walls must exist, and numbers must be finite. */
static int demi_rails_check(const demi_reader *r) {
    int i, k;
    for (i = 0; i < r->t->rail_count; i++) {
        const demi_rail *a = &r->t->rails[i];
        if (demi_rows_bad(r->w, demi_rail_fields, &a->state.desc, &k) || a->body.slot < 1 ||
            a->body.slot > (uint32_t)r->t->bodies.slot_count ||
            a->state.desc.wall.id < 0 || (a->state.desc.wall.id &&
             demi_wall_place(a->state.desc.wall) >= r->t->wall_count) ||
            !demi_finite_double(a->state.work) || !demi_quat_finite(a->start) ||
            !demi_place(a->turn) || !demi_place(a->at) || !demi_place(a->seen) ||
            !demi_place(a->on))
            return demi_lie(r, "rail", i);
    }
    return 1;
}
static dem_result demi_rails_whole(dem_world *w, const char *call) {
    if (!demi_rails_in_force(w)) return DEM_OK;
    return demi_refuse(w, call, "%d bodies are on rails (dem_body_rail_set), whose state slabs do "
                       "not pass on; use threads, or walls instead of these bodies",
                       demi_rails_in_force(w));
}
