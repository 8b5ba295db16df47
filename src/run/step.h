/* ---------------------------------------------------------------------------------------------
   >>step
   Time integration: one step, in the stages that section 10 of the manual lists, for all members
   of a team together (>>team), that is for a single world or for slabs. A phase runs over the work
   groups of a member in parallel. It ends when all groups have finished, because the next phase
   needs their results: after the move, which bodies came near each other; after touch, whether the
   lists had room; after respond, the forces on bodies of other groups.
   This part owns the time, the stages of demi_stages, the displacements since the last rebuild, and
   the poses and loads of walls. Integrators (>>integrators) move the bodies, responses
   (>>responses) compute the forces.
   A step begins with the forces that the previous step computed. Its second half kick is left open
   until the state is read (demi_finish), because the first half kick of the next step adds the same
   force: so velocities are written once per step instead of twice. Quantities that only a reader
   needs, for example the kinetic energy, are computed when they are read. An error is found in the
   step that caused it, and the message names the body. A step that ran out of memory after its move
   is marked by stage.moved; the next call continues it.
   --------------------------------------------------------------------------------------------- */

/* Largest |v|^2 and |a|^2 of some bodies, and the sum of |v|^2. The sum is not finite if any
   velocity is not finite; a maximum would lose that. Each lane has its own maxima and sum, so that
   the compiler vectorizes the loop over bodies. */
typedef struct demi_pace {
    /* (m/s)^2, of half-step velocities; (m/s2)^2, of the forces that move the bodies; (m/s)^2 */
    dem_real speed2[DEMI_LANES], acceleration2[DEMI_LANES], sum[DEMI_LANES];
} demi_pace;
/* Adds body i to lane l. */
DEM_INLINE void demi_pace_look(const dem_world *w, int i, demi_pace *DEMI_RESTRICT pace, int l) {
    const dem_real *v = w->bodies.half_vel + 4*i, *f = w->bodies.force + 4*i,
        inv = w->bodies.inv_mass[i];
    const dem_vec3 g = w->desc.gravity;
    const dem_real s = v[0]*v[0] + v[1]*v[1] + v[2]*v[2];
    const dem_real x = f[0]*inv + g.x, y = f[1]*inv + g.y, z = f[2]*inv + g.z;
    const dem_real a = x*x + y*y + z*z;
    pace->speed2[l] = s > pace->speed2[l] ? s : pace->speed2[l];
    pace->acceleration2[l] = a > pace->acceleration2[l] ? a : pace->acceleration2[l];
    pace->sum[l] += s;
}
/* Moves the bodies begin .. end - 1 of a work group by one step, adds them to `pace`, and sets
   their forces to 0; if `turning`, also rotates them and sets their torques to 0. */
static void demi_some_move(dem_world *w, demi_domain *domain, int begin, int end, int turning,
                           demi_pace *pace) {
    const size_t bytes = (size_t)(end - begin)*4*sizeof(dem_real);
    int i, l;
    if (w->bodies.booked && !w->stage.synced) demi_late_note(w, begin, end);
    demi_integrator_of(w)->advance(w, begin, end, turning);
    if (w->cell.on) demi_cell_carry(w, begin, end);
    if (w->desc.planar)
        for (i = begin; i < end; i++) {
            w->bodies.pos[4*i + 2] = w->bodies.vel[4*i + 2] = 0;
            w->bodies.spin[4*i] = w->bodies.spin[4*i + 1] = 0;
            w->bodies.half_vel[4*i + 2] = w->bodies.half_spin[4*i] = w->bodies.half_spin[4*i + 1] =
                0;
        }
    if (w->bodies.orienting) demi_orient_move(w, domain, begin, end);
    if (demi_response_is(w, DEMI_MIDWAY)) memset(w->bodies.went + begin, 1, (size_t)(end - begin));
    for (i = begin; i + DEMI_LANES <= end; i += DEMI_LANES) {
        DEMI_VECTOR
        for (l = 0; l < DEMI_LANES; l++) demi_pace_look(w, i + l, pace, l);
    }
    for (; i < end; i++) demi_pace_look(w, i, pace, 0);
    memset(w->bodies.force + 4*begin, 0, bytes);
    if (turning) memset(w->bodies.torque + 4*begin, 0, bytes);
}
/* The same for a whole work group in which some bodies may be isolated (demi_quiet). Isolated
   bodies keep their velocity: only their positions change, and their stored speed is used. */
static void demi_quiet_move(dem_world *w, int d, int turning, demi_pace *pace) {
    demi_domain *domain = &w->domains[d];
    const dem_real *DEMI_RESTRICT u = w->bodies.half_vel, dt = w->clock.dt;
    dem_real *DEMI_RESTRICT x = w->bodies.pos;
    int i, k, end, l;
    for (i = domain->begin; i < domain->end; i = end) {
        demi_quiet *q = demi_quiet_at(w, d, i);
        end = DEMI_MIN((i/DEMI_SOME + 1)*DEMI_SOME, domain->end);
        if (q->restless) {
            demi_pace own;
            memset(&own, 0, sizeof own);
            demi_some_move(w, domain, i, end, turning, &own);
            q->speed2 = 0;
            for (l = 0; l < DEMI_LANES; l++) {
                q->speed2 = DEMI_MAX(q->speed2, own.speed2[l]);
                pace->acceleration2[l] = DEMI_MAX(pace->acceleration2[l], own.acceleration2[l]);
                pace->sum[l] += own.sum[l];
            }
            if (q->restless == 1) q->restless = 0;
        } else {
            for (k = 4*i; k < 4*end; k++) x[k] += u[k]*dt;
            if (w->bodies.orienting) demi_orient_move(w, domain, i, end);
        }
        pace->speed2[0] = DEMI_MAX(pace->speed2[0], q->speed2);
    }
}
/* Returns the work of gravity in this step on the bodies of a work group, J: their momentum times
   g dt. The fourth column is summed only so that the loop vectorizes. Bodies that do not move add
   nothing, because their velocity is 0. */
static double demi_gravity_work(const dem_world *w, const demi_domain *domain) {
    const dem_real *DEMI_RESTRICT u = w->bodies.half_vel, *DEMI_RESTRICT mass = w->bodies.mass;
    const dem_vec3 g = w->desc.gravity;
    double momentum[4] = {0, 0, 0, 0};
    int i, k;
    for (i = domain->begin; i < domain->end; i++)
        for (k = 0; k < 4; k++) momentum[k] += (double)mass[i]*(double)u[4*i + k];
    return ((double)g.x*momentum[0] + (double)g.y*momentum[1] + (double)g.z*momentum[2])*
        (double)w->clock.dt;
}
/* Moves all bodies of work group d, a few at a time, and stores the maxima and sums found on the
   way in the group. */
static void demi_domain_move(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    const int turning = demi_turns(w), some = 64;   /* these stay in the nearest cache */
    demi_pace pace;
    int i;
    memset(&pace, 0, sizeof pace);
    domain->speed2 = domain->acceleration2 = domain->check = 0;
    domain->turn = domain->turn_speed = domain->turn_rate = 0;
    if (w->stage.quiet) demi_quiet_move(w, d, turning, &pace);
    else for (i = domain->begin; i < domain->end; i += some)
        demi_some_move(w, domain, i, DEMI_MIN(i + some, domain->end), turning, &pace);
    for (i = 0; i < DEMI_LANES; i++) {
        domain->speed2 = DEMI_MAX(domain->speed2, (double)pace.speed2[i]);
        domain->acceleration2 = DEMI_MAX(domain->acceleration2, (double)pace.acceleration2[i]);
        domain->check += (double)pace.sum[i];
    }
    /* midpoint rule: between two contact detections bodies move with full-step velocities */
    for (i = domain->begin; i < domain->end && demi_response_is(w, DEMI_MIDWAY); i++) {
        const dem_vec3 v = demi_at(w->bodies.vel + 4*i);
        domain->speed2 = DEMI_MAX(domain->speed2, (double)demi_dot(v, v));
    }
    if (w->desc.ledger) domain->energy[DEMI_E_GRAVITY] = demi_gravity_work(w, domain);
}

/* Time, s, and velocity that force fields receive: the present ones. With the midpoint rule those
   in the middle of the next step: velocities are extrapolated with the change of the last step. */
static double demi_field_time(const dem_world *w) {
    return w->clock.time + (demi_response_is(w, DEMI_MIDWAY) ? (double)w->clock.dt/2 : 0);
}
DEM_INLINE dem_vec3 demi_field_rate(const dem_world *w, const dem_real *now, const dem_real *half,
                                    int i) {
    const dem_vec3 v = demi_at(now + 4*i);
    return demi_response_is(w, DEMI_MIDWAY) ? demi_sub(demi_scale(v, 2), demi_at(half + 4*i)) : v;
}
/* Adds the forces and torques of desc.body_force to the bodies of work group d. */
static void demi_domain_fields(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    int i;
    for (i = domain->begin; i < domain->end; i++) {
        const dem_body id = dem_body_id_get(w, i);
        const dem_vec3 none = demi_v(0, 0, 0);
        dem_vec3 force = none, torque = none;
        dem_body_state body;
        if (demi_is_ghost(w, i) || dem_body_get(w, id, &body) != DEM_OK) continue;
        body.velocity = demi_field_rate(w, w->bodies.vel, w->bodies.half_vel, i);
        body.spin = demi_field_rate(w, w->bodies.spin, w->bodies.half_spin, i);
        DEMI_USER(w, "a step", 1, w->desc.body_force(&body, id, demi_field_time(w), &force, &torque,
                                                     w->desc.force_user))
        demi_force_add(w->bodies.force + 4*i, force);
        demi_force_add(w->bodies.torque + 4*i, torque);
        if (w->desc.ledger && w->stage.forces_valid && w->bodies.inv_mass[i] > 0)
            domain->energy[DEMI_E_FORCE] += (double)(demi_dot(force, body.velocity) +
                                                     demi_dot(torque,
                                                              body.spin))*(double)w->clock.dt;
    }
}
/* Discs stay in the plane z = 0 and rotate about z only. */
static void demi_domain_flatten(dem_world *w, int d) {
    int i;
    for (i = w->domains[d].begin; i < w->domains[d].end; i++)
        w->bodies.force[4*i + 2] = w->bodies.torque[4*i] = w->bodies.torque[4*i + 1] = 0;
}
/* Starts the sums of forces and torques of work group d: with 0, or with the force fields. The move
   of a step has already set forces to 0. */
static void demi_domain_clear(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    const size_t n = (size_t)(domain->end - domain->begin)*4*sizeof(dem_real);
    int i;
    if (n && !w->stage.moved) {
        memset(w->bodies.force + 4*domain->begin, 0, n);
        memset(w->bodies.torque + 4*domain->begin, 0, n);
    }
    if (n && w->bodies.real_count)
        memset(w->bodies.rates + w->bodies.real_count*domain->begin, 0,
               (size_t)w->bodies.real_count*n/4);
    for (i = domain->begin; i < domain->end && w->desc.force; i++) {
        if (demi_is_ghost(w, i)) continue;
        const dem_vec3 v = demi_field_rate(w, w->bodies.vel, w->bodies.half_vel, i);
        dem_vec3 f;
        DEMI_USER(w, "a step", 1, f = w->desc.force(demi_at(w->bodies.pos + 4*i), v,
                                                    demi_radius(w, i), w->bodies.mass[i],
                                                    demi_field_time(w), w->desc.force_user))
        demi_put(w->bodies.force + 4*i, f);
        if (w->desc.ledger && w->stage.forces_valid && w->bodies.inv_mass[i] > 0)
            w->domains[d].energy[DEMI_E_FORCE] += (double)demi_dot(f, v)*(double)w->clock.dt;
    }
    if (w->desc.body_force) demi_domain_fields(w, d);
    if (w->desc.planar && (w->desc.force || w->desc.body_force)) demi_domain_flatten(w, d);
    if (w->cell.on) demi_cell_drag(w, domain);
}
/* Computes the forces of all contacts that work group d owns. Forces on its own bodies are added
   here. Forces on bodies of other groups are stored in cross_force until all groups have finished
   (demi_cross_gather). */
static void demi_domain_respond(dem_world *w, int d) {
    const demi_response_row *response = &demi_responses[w->desc.response];
    const size_t walls = (size_t)w->wall_count;
    demi_domain_clear(w, d);
    if (walls) memset(w->wall_sums + (size_t)d*walls, 0, walls*sizeof *w->wall_sums);
    if (walls && demi_exchanges(w)) {
        const size_t row = (size_t)w->bodies.real_count*walls;
        memset(w->wall_rates + (size_t)d*row, 0, row*sizeof *w->wall_rates);
    }
    if (response->respond) response->respond(w, d);
}
/* Adds the forces that contacts of other work groups exert on the bodies of group d, in the order
   of cross_incoming. With user-defined functions, which may return any number, it also stores a sum
   that is not below 1e300 if any force or user-defined number is not finite or too large. */
static void demi_domain_gather(dem_world *w, int d) {
    int i;
    if (w->cross_entries && demi_responses[w->desc.response].respond) demi_cross_gather(w, d);
    if (demi_own(w)) {
        double sum = 0;
        for (i = 4*w->domains[d].begin; i < 4*w->domains[d].end; i++)
            sum += fabs((double)w->bodies.force[i]) + fabs((double)w->bodies.torque[i]);
        for (i = w->bodies.real_count*w->domains[d].begin;
             i < w->bodies.real_count*w->domains[d].end; i++)
            sum += fabs((double)w->bodies.rates[i]) + fabs((double)w->bodies.reals[i]);
        w->domains[d].check = sum;
    }
    if (w->desc.planar) demi_domain_flatten(w, d);
}
/* Sums the rates, per second, of the walls' user-defined numbers over the work groups, in order. */
static void demi_walls_rates(dem_world *w) {
    const size_t n = (size_t)w->bodies.real_count, walls = (size_t)w->wall_count;
    size_t i, k;
    int d;
    for (i = 0; i < walls; i++)
        for (k = 0; k < n; k++) {
            dem_wall_loads *c = &w->walls[i].loads;
            c->rate[k] = 0;
            for (d = 0; d < w->domain_count; d++)
                c->rate[k] += w->wall_rates[n*((size_t)d*walls + i) + k];
        }
}
/* Adds force f, N, and power, W, of a time dt, s, to the sums of a wall's loads. */
static void demi_loads_add(dem_wall_loads *c, const double *f, double power, double dt) {
    int k;
    for (k = 0; k < 3; k++) c->impulse[k] += f[k]*dt;
    c->torque_impulse += (double)c->torque_axial*dt;
    c->work += power*dt;
    c->time += dt;
}
/* Impulses: adds the loads of the step whose bodies have just moved. They were solved before, and
   again if the scene had changed since. */
static void demi_walls_bear(dem_world *w) {
    int i;
    for (i = 0; i < w->wall_count; i++) {
        dem_wall_loads *c = &w->walls[i].loads;
        const double f[3] = {(double)c->force.x, (double)c->force.y, (double)c->force.z};
        if (w->walls[i].kind != DEMI_WALL_NONE)
            demi_loads_add(c, f, (double)c->power, (double)w->clock.dt);
    }
}
/* Computes the forces at the present positions and velocities, and the loads of walls. The
   persistent contacts found by touch become the present ones. If forces_valid is 0 the forces
   belong to no step (demi_refresh): contact histories and time integrals of loads stay as they are.
   Returns 0 if memory ran out. */
static int demi_forces(dem_world *w) {
    const double dt = w->stage.forces_valid ? (double)w->clock.dt : 0;
    const demi_response_row *response = &demi_responses[w->desc.response];
    demi_persistent *last = w->persistent_now;
    int d, i, k;
    if ((response->room && !response->room(w)) || (w->events.n.on && !demi_notes_room(w))) return 0;
    for (d = 0; d < w->domain_count; d++) {
        w->domains[d].overlap = 0;
        for (i = 0; i < DEMI_ENERGIES; i++) w->domains[d].energy[i] = 0;
        if (w->cell.on) memset(w->domains[d].cell, 0, sizeof w->domains[d].cell);
    }
    demi_domains_do(w, demi_domain_respond);
    if (response->solve) response->solve(w);
    demi_domains_do(w, demi_domain_gather);
    w->persistent_now = w->persistent_next;
    w->persistent_next = last;
    for (d = 0; d < w->domain_count; d++) w->domains[d].persistent = w->domains[d].persistent_next;
    if (w->threads.now > 1) demi_domains_weigh(w);
    for (i = 0; i < w->wall_count; i++) {  /* sums in the order of groups, for any threads */
        dem_wall_loads *c = &w->walls[i].loads;
        const dem_vec3 axis = w->walls[i].motion.axis;
        double f[3] = {0, 0, 0}, t[3] = {0, 0, 0}, power = 0;
        if (w->walls[i].kind == DEMI_WALL_NONE) continue;
        c->contacts = 0;
        for (d = 0; d < w->domain_count; d++) {
            const demi_wall_sum *s = &w->wall_sums[d*w->wall_count + i];
            for (k = 0; k < 3; k++) { f[k] += s->force[k]; t[k] += s->torque[k]; }
            power += s->power;
            c->contacts += s->contacts;
        }
        c->force = demi_v((dem_real)f[0], (dem_real)f[1], (dem_real)f[2]);
        c->torque = demi_v((dem_real)t[0], (dem_real)t[1], (dem_real)t[2]);
        c->torque_axial = demi_dot(c->torque, demi_unit(axis));
        c->power = (dem_real)power;
        c->touched |= c->contacts > 0;
        if (!demi_response_is(w, DEMI_MIDWAY)) demi_loads_add(c, f, power, dt);
    }
    if (demi_exchanges(w)) demi_walls_rates(w);
    w->booked.overlap_max = DEMI_MAX(w->booked.overlap_max, demi_overlap(w));
    if (w->booked.overlap_max > DEMI_MAX(w->booked.crushed.next, DEMI_OVERLAP_LIMIT))
        demi_crushed_note(w);
    if (w->material_count == 1 && w->booked.overlap_max > 0) w->booked.met[0] = 1;
    response->book(w);
    return 1;
}

/* Fails with a message that names the body at fault, and the likely cause. Tested in this order:
   numbers that are not finite, an overlap of at least the radius, and otherwise the body with the
   largest speed or acceleration. */
static dem_result demi_unstable(dem_world *w) {
    int i, d, first = 0, second = 0, wall = 0;
    double deepest;
    for (i = 0; i < w->bodies.count; i++)
        if (!demi_finite3(demi_at(w->bodies.pos + 4*i)) ||
            !demi_finite3(demi_at(w->bodies.vel + 4*i)) ||
            !demi_finite3(demi_at(w->bodies.spin + 4*i)) ||
                !demi_finite3(demi_at(w->bodies.force + 4*i)) ||
            !demi_finite3(demi_at(w->bodies.torque + 4*i)))
            return demi_fail(w, DEM_ERROR_UNSTABLE, "dem_world_step: step %llu, body %u: its "
                             "position, velocity or spin is no longer a finite number; likely two "
                             "grains are at the same position, a user-defined law, force field or "
                             "motion divided by zero, or dt = %g s is too large",
                             (unsigned long long)w->clock.steps, (unsigned)w->bodies.slot[i] + 1,
                             (double)w->clock.dt);
    for (i = 0; i < w->bodies.count*w->bodies.real_count; i++) {
        const int k = i%w->bodies.real_count;
        int n;
        const char *name = demi_name(w->real_names, k, &n);
        if (!(fabs((double)w->bodies.reals[i]) + fabs((double)w->bodies.rates[i]) < 1e300))
            return demi_fail(w, DEM_ERROR_UNSTABLE, "dem_world_step: step %llu, body %u: its %.*s "
                             "is %g with a rate of %g, no longer a finite number; likely it "
                             "oscillates from step to step, because dt = %g s must be below 2 "
                             "over its fastest rate of decay (use a larger capacity or a smaller "
                             "dt), or your law or body_reals_fn divided by zero",
                             (unsigned long long)w->clock.steps,
                             (unsigned)w->bodies.slot[i/w->bodies.real_count] + 1, n, name,
                             (double)w->bodies.reals[i], (double)w->bodies.rates[i],
                             (double)w->clock.dt);
    }
    deepest = demi_deepest(w, &first, &second, &wall);
    if (!(deepest >= 1)) {
        double most = 0;
        for (i = 0; i < w->bodies.count; i++)
            for (d = 0; d < 3; d++) {
                const double v = fabs((double)w->bodies.vel[4*i + d]);
                const double f = fabs((double)w->bodies.force[4*i + d]);
                const double size = DEMI_MAX(v, f*(double)w->bodies.inv_mass[i]);
                if (size > most) { most = size; first = i; }
            }
        return demi_fail(w, DEM_ERROR_UNSTABLE, "dem_world_step: step %llu, body %u: its force, "
                         "speed or position is too large to calculate with; a user-defined law, "
                         "force field or motion returned a huge number, or dt = %g s is too large",
                         (unsigned long long)w->clock.steps, (unsigned)w->bodies.slot[first] + 1,
                         (double)w->clock.dt);
    }
    if (second < 0)
        return demi_fail(w, DEM_ERROR_UNSTABLE, "dem_world_step: step %llu, body %u "
                         "overlaps wall %d by %.3g of its radius, must be below 1; it "
                         "started inside the wall, hit it too fast for dt = %g s, or the "
                         "material is too soft", (unsigned long long)w->clock.steps,
                         (unsigned)w->bodies.slot[first] + 1, (int)w->walls[wall].id, deepest,
                         (double)w->clock.dt);
    return demi_fail(w, DEM_ERROR_UNSTABLE, "dem_world_step: step %llu: bodies %u and %u overlap "
                     "by %.3g of the smaller radius, must be below 1; they started inside each "
                     "other, collided too fast for dt = %g s, or the material is too soft",
                     (unsigned long long)w->clock.steps, (unsigned)w->bodies.slot[first] + 1,
                     (unsigned)w->bodies.slot[second] + 1, deepest, (double)w->clock.dt);
}

/* True if the domain has an outflow boundary. */
static int demi_outflows(const dem_world *w) {
    const dem_boundary *b = w->desc.boundary;
    return b[0] == DEM_BOUNDARY_OUTFLOW || b[1] == DEM_BOUNDARY_OUTFLOW ||
        b[2] == DEM_BOUNDARY_OUTFLOW;
}
/* Removes the bodies whose centre has left through an outflow boundary. */
static dem_result demi_outflow(dem_world *w) {
    double lo[3], hi[3];
    int i, k;
    demi_domain_limits(w, lo, hi);
    for (i = 0; i < w->bodies.count; i++)
        for (k = 0; k < 3; k++) {
            const double x = (double)w->bodies.pos[4*i + k];
            if (w->desc.boundary[k] != DEM_BOUNDARY_OUTFLOW || (x >= lo[k] && x <= hi[k])) continue;
            if (!demi_list_drop(w)) return demi_no_memory(w, "dem_world_step");
            demi_body_lose(w, i--, &w->bodies.balance.left);
            break;
        }
    return DEM_OK;
}

/* Advances the time by one step. The time is computed from the start of the present step length,
   so that rounding errors do not accumulate (demi_since). */
static void demi_time_pass(dem_world *w) {
    const double dt = (double)w->clock.dt;
    if (w->clock.since.dt < dt || w->clock.since.dt > dt) {
        w->clock.since.time = w->clock.time;
        w->clock.since.steps = w->clock.steps;
        w->clock.since.dt = dt;
    }
    w->clock.steps++;
    w->clock.time = w->clock.since.time + (double)(w->clock.steps - w->clock.since.steps)*dt;
}
/* 1 move: first half kick, drift, predicted velocities; walls follow their motions. Also computes
   what the move says about the lists: largest speed and displacements. Fails if a velocity is not
   finite, a body rotates too far in the step, or a motion gives an impossible pose. */
static dem_result demi_step_move(dem_world *w) {
    double speed2 = 0, acceleration2 = 0, turn = 0, turn_speed = 0, turn_rate = 0;
    int d, i;
    w->clock.half_kick = (double)w->clock.dt/2;
    demi_domains_do(w, demi_domain_move);
    w->stage.synced = demi_response_is(w, DEMI_MIDWAY);
    DEMI_MEMBER_PHASE(w, moved)
    demi_time_pass(w);
    for (d = 0; d < w->domain_count; d++) {
        const double s = w->domains[d].check;
        if (!(s < 1e300) || (DEMI_SINGLE && !(s < 1e37))) return demi_unstable(w);
        speed2 = DEMI_MAX(speed2, w->domains[d].speed2);
        acceleration2 = DEMI_MAX(acceleration2, w->domains[d].acceleration2);
        turn = DEMI_MAX(turn, w->domains[d].turn);
        turn_speed = DEMI_MAX(turn_speed, w->domains[d].turn_speed);
        turn_rate = DEMI_MAX(turn_rate, w->domains[d].turn_rate);
    }
    /* the power series of demi_orient_move are valid up to there */
    if (sqrt(turn_rate)*(double)w->clock.dt > (w->desc.allow_large_dt ? 2 : 1))
        return demi_spins_refuse(w, sqrt(turn_rate), "dem_world_step");
    w->booked.speed_max = sqrt(speed2);
    w->margin.pace = w->booked.speed_max + sqrt(turn_speed);
    w->margin.step_gone =
        (w->booked.speed_max + (w->effects.tight ? sqrt(turn_speed) : 0))*(double)w->clock.dt +
        w->cell.squeeze/2;
    w->margin.last_change = sqrt(acceleration2)*(double)w->clock.dt + sqrt(turn);
    if (demi_response_is(w, DEMI_MIDWAY)) demi_walls_bear(w);
    if (w->desc.ledger) {
        demi_work_book(w, DEMI_E_GRAVITY, demi_sum_energy(w, DEMI_E_GRAVITY));
        demi_due_book(w);
        if (w->events.n.on) demi_events_due(w);
    }
    for (i = 0; i < w->wall_count; i++) {
        demi_wall *wall = &w->walls[i];
        dem_pose pose = wall->pose, mid = wall->mid;
        if (demi_response_is(w, DEMI_MIDWAY)) wall->was = wall->ahead;     /* once per step */
        if (wall->kind == DEMI_WALL_NONE || wall->motion.kind == DEM_MOTION_FIXED) continue;
        demi_wall_pose_at(w, wall, w->clock.time, &pose);
        if (!demi_response_is(w, DEMI_MIDWAY))
            demi_wall_pose_at(w, wall, w->clock.time - w->clock.half_kick, &mid);
        if (!demi_pose_sane(&pose) || !demi_pose_sane(&mid)) {
            w->stage.forces_valid = 0;          /* the wall stays where it was, finite */
            w->margin.walls_gone = 1e300;
            return demi_fail(w, DEM_ERROR_UNSTABLE, "dem_world_step: step %llu: the motion of "
                             "wall %d gave a pose that is not finite, whose matrix is not a "
                             "rotation, or that is beyond %g m, m/s or rad/s at %g s; check the "
                             "motion", (unsigned long long)w->clock.steps, i + 1, DEMI_FARTHEST,
                             w->clock.time);
        }
        if (w->rail_count) demi_rails_carry(w, i, &mid, &pose);
        wall->pose = pose;
        wall->mid = mid;
        const double speed = demi_wall_pace(w, i);
        if (speed < 0) w->margin.walls_gone = 1e300;   /* no bound: search in every step */
        else w->wall_fastest = DEMI_MAX(w->wall_fastest, speed);
    }
    w->margin.walls_gone += w->wall_fastest*(double)w->clock.dt;
    w->wall_fastest = 0;
    return DEM_OK;
}

/* Integrates the user-defined numbers of work group d over the step: by body_reals_fn, or by the
   explicit Euler scheme. */
static void demi_domain_gain(dem_world *w, int d) {
    const int n = w->bodies.real_count;
    const dem_real dt = w->clock.dt;
    int i, k;
    for (i = w->domains[d].begin; i < w->domains[d].end; i++) {
        dem_real *reals = w->bodies.reals + n*i;
        const dem_real *rates = w->bodies.rates + n*i;
        const dem_body id = dem_body_id_get(w, i);
        dem_body_state body;
        if (demi_is_ghost(w, i)) continue;
        if (!w->desc.body_reals_fn) for (k = 0; k < n; k++) reals[k] += rates[k]*dt;
        else if (dem_body_get(w, id, &body) == DEM_OK)
            DEMI_USER(w, "a step", 1,
                      w->desc.body_reals_fn(reals, rates, &body, id, w->clock.time, dt,
                                            w->desc.body_reals_user))
    }
}
/* Integrates the user-defined numbers of bodies, and what walls have gained of them, over the step.
   Called once per step, and not when forces are computed without a step. */
static void demi_reals_gain(dem_world *w) {
    int i, k;
    if (!w->bodies.real_count) return;
    demi_domains_do(w, demi_domain_gain);
    for (i = 0; i < w->wall_count; i++)
        for (k = 0; k < w->bodies.real_count; k++)
            w->walls[i].loads.gained[k] += w->walls[i].loads.rate[k]*(double)w->clock.dt;
}

/* The record (demi_record) of forces: a ghost's force, torque if bodies rotate, and rates of
   user-defined numbers, which are added to those of its owner. */
static size_t demi_pushes_size(const dem_world *w) {
    return ((demi_turns(w) ? 6 : 3) + (size_t)w->bodies.real_count)*sizeof(dem_real);
}
static void demi_pushes_put(const dem_world *w, int i, char *to) {
    const size_t three = 3*sizeof(dem_real), own = (size_t)w->bodies.real_count;
    memcpy(to, w->bodies.force + 4*i, three);
    if (demi_turns(w)) memcpy(to += three, w->bodies.torque + 4*i, three);
    if (own) memcpy(to + three, w->bodies.rates + own*(size_t)i, own*sizeof(dem_real));
}
static void demi_pushes_take(dem_world *w, int i, const char *from) {
    const size_t own = (size_t)w->bodies.real_count, turns = demi_turns(w) ? 6 : 3;
    dem_real x;
    size_t k;
    for (k = 0; k < turns + own; k++) {
        memcpy(&x, from + k*sizeof x, sizeof x);
        *(k < 3 ? w->bodies.force + 4*i + k : k < turns ? w->bodies.torque + 4*i + k - 3
          : w->bodies.rates + own*(size_t)i + k - turns) += x;
    }
}
static const demi_record demi_pushes = {demi_pushes_size, demi_pushes_put, demi_pushes_take};

/* --- the phases of a step, each for one member --- */

/* Moves the bodies unless this step has moved them already. Ghosts rest: their owner moves them. */
static dem_result demi_member_move(dem_world *w) {
    dem_result result;
    if (w->stage.moved) return DEM_OK;
    if (w->team) w->team->rest(w);
    result = demi_step_move(w);
    w->stage.moved = result == DEM_OK;
    return result;
}
/* Rebuilds the pruned neighbour list if it is due, or was when memory ran out: by the span chosen
   for the next list it may not be. */
static dem_result demi_member_near(dem_world *w) {
    if (!w->stage.near_stale && !w->stage.near_chosen && !demi_near_due(w)) return DEM_OK;
    if (!w->stage.near_chosen && demi_near_worn(w)) demi_near_choose(w);
    w->stage.near_chosen = 1;
    if (!demi_near_make(w, 0)) return demi_no_memory(w, "dem_world_step");
    w->stage.near_chosen = 0;
    return DEM_OK;
}
static dem_result demi_member_touch(dem_world *w) {
    return demi_touch(w) ? DEM_OK : demi_no_memory(w, "dem_world_step");
}
static dem_result demi_member_forces(dem_world *w) {
    return demi_forces(w) ? DEM_OK : demi_no_memory(w, "dem_world_step");
}
/* Ends a step when all forces are known; only the second half kick stays open (see above). Fails if
   user-defined functions returned impossible numbers, or an overlap has reached the radius. */
static dem_result demi_member_end(dem_world *w) {
    int d;
    DEMI_MEMBER_PHASE(w, acted)
    w->stage.moved = 0;
    for (d = 0; d < w->domain_count && demi_own(w); d++)
        if (!(w->domains[d].check < 1e300)) return demi_unstable(w);
    return demi_overlap(w) < 1 ? DEM_OK : demi_unstable(w);
}
static dem_result demi_member_prime(dem_world *w) {
    demi_finish(w);
    demi_prime(w);
    return DEM_OK;
}
/* Run before and after forces are computed without a step. forces_valid = 0 makes contact histories
   stay as they are. */
static dem_result demi_member_look(dem_world *w) {
    w->stage.forces_valid = 0;
    return DEM_OK;
}
static dem_result demi_member_looked(dem_world *w) {
    if (!(demi_overlap(w) < 1)) return demi_unstable(w);
    DEMI_MEMBER_PHASE(w, acted)
    w->stage.forces_valid = 1;
    return DEM_OK;
}

/* --- the step of a scene --- */

/* Copies the poses of moving walls from the first member, the only one of a process whose walls
   move, so that a user-defined motion is called once per step. */
static void demi_walls_follow(dem_world *w, const dem_world *first) {
    int i;
    for (i = 0; i < w->wall_count && w != first; i++) {
        if (first->walls[i].motion.kind == DEM_MOTION_FIXED) continue;
        w->walls[i].pose = first->walls[i].pose;
        w->walls[i].mid = first->walls[i].mid;
    }
}

/* After a move: copies the time to the head, and takes maxima over all members of the speed and of
   the displacements that limit the life of lists. Sets near_due if the pruned list of any member
   may be due; then each member decides about its own (demi_member_near). */
static dem_result demi_moved(dem_world *h) {
    enum { SPEED, WALLS, CHANGE, CREEP, AGE, GONE, COUNT };
    const dem_world *first = demi_member(h, 0);
    const double dt = (double)h->clock.dt;
    double most[COUNT] = {0, 0, 0, -1e300, -1e300, 0};
    dem_result result;
    int k;
    for (k = 0; k < demi_members(h); k++) {
        const dem_world *w = demi_member(h, k);
        const demi_margin *m = &w->margin;
        most[SPEED] = DEMI_MAX(most[SPEED], w->booked.speed_max);
        most[WALLS] = DEMI_MAX(most[WALLS], m->walls_gone);
        most[CHANGE] = DEMI_MAX(most[CHANGE], m->last_change);
        most[CREEP] = DEMI_MAX(most[CREEP], m->creep + 2*m->change*dt - m->slack);
        most[AGE] = DEMI_MAX(most[AGE], m->age + dt - m->span*(1 - 1e-9));
        most[GONE] = DEMI_MAX(most[GONE], m->step_gone);
    }
    result = demi_agree(h, most, COUNT);
    h->stage.moved = 1;
    h->clock.time = first->clock.time;
    h->clock.since = first->clock.since;
    h->clock.steps = first->clock.steps;
    h->booked.speed_max = most[SPEED];
    h->margin.last_change = most[CHANGE];
    h->margin.gone += most[GONE];
    h->margin.walls_gone = most[WALLS];
    h->near_due = most[CREEP] + 2*most[CHANGE]*dt > -1e-6*h->margin.skin || most[AGE] > -1e-6*dt;
    for (k = 0; k < demi_members(h); k++) {
        dem_world *w = demi_member(h, k);
        w->margin.gone = h->margin.gone;
        w->margin.walls_gone = h->margin.walls_gone;
        demi_walls_follow(w, first);
        demi_near_pass(w, most[CHANGE]);
    }
    return result;
}
/* Runs a task that may remove bodies. If some member then needs a new list, all get one. */
static dem_result demi_all_lose(dem_world *h, dem_result (*task)(dem_world *member)) {
    double most = 0;
    dem_result result = demi_all(h, task);
    int k;
    for (k = 0; k < demi_members(h); k++)
        most = DEMI_MAX(most, !demi_member(h, k)->stage.list_valid);
    if (result == DEM_OK) result = demi_agree(h, &most, 1);
    if (most > 0) demi_list_outdated(h);
    return result;
}
/* True if the list is not valid, or a pair that is not in it may have come near. */
static int demi_list_due(const dem_world *h) {
    const demi_margin *m = &h->margin;
    return !h->stage.list_valid || m->skin <= 0 || 2*m->gone > m->skin ||
        m->gone + m->walls_gone > m->skin;
}
/* Removes bodies by where they are at the end of the step. Outlets act when lists are rebuilt and
   every DEMI_OUTLET_REST steps: between two lists no body moves farther than half a skin. */
static dem_result demi_step_lose(dem_world *h) {
    dem_result result = demi_outflows(h) ? demi_all_lose(h, demi_outflow) : DEM_OK;
    if (result == DEM_OK && demi_member(h, 0)->outlet_count &&
        (demi_list_due(h) || h->clock.steps%DEMI_OUTLET_REST == 0))
        result = demi_all_lose(h, demi_outlets_run);
    return result;
}
/* Builds the neighbour lists of all members. */
static dem_result demi_all_rebuild(dem_world *h) {
    return h->team ? h->team->rebuild(h) : demi_rebuild(h, "dem_world_step");
}
/* Computes all forces: 3 touch, 4 respond, 5 gather. near: 1 if pruned lists may be due. Lists of
   contacts of spheres always have room (demi_persistent_room). With other shapes the members first
   agree that touch has succeeded in all of them, and only then compute forces, because a contact
   history may advance only once per step. */
static dem_result demi_all_forces(dem_world *h, int near) {
    dem_result result = h->team ? h->team->lend(h) : DEM_OK;
    if (result == DEM_OK && near) result = demi_all_agree(h, demi_member_near);
    if (result == DEM_OK) result = demi_all(h, demi_member_touch);
    if (result == DEM_OK && demi_member(h, 0)->bodies.orienting) result = demi_agree(h, 0, 0);
    DEMI_PHASE(h, result, found)
    if (result == DEM_OK) result = demi_all(h, demi_member_forces);
    if (result == DEM_OK && h->team) result = h->team->give(h, &demi_pushes);
    DEMI_PHASE(h, result, answered)
    return result;
}
/* Fails after a step with an overlap above desc.overlap_stop. */
static dem_result demi_member_crushed(dem_world *w) {
    const double overlap = demi_overlap(w);
    int a = 0, b = 0, wall = 0;
    if (!(overlap > (double)w->desc.overlap_stop)) return DEM_OK;
    demi_deepest(w, &a, &b, &wall);
    return demi_fail(w, DEM_ERROR_STOPPED, "dem_world_step: step %llu: body %u overlaps %s %u by "
                     "%.3g R, must be at most desc.overlap_stop = %g R; grains are jammed or too "
                     "soft: take a higher modulus, more room or lower speeds, or go on with "
                     "desc.overlap_stop = 0", (unsigned long long)w->clock.steps,
                     (unsigned)w->bodies.slot[a] + 1, b < 0 ? "wall" : "body",
                     b < 0 ? (unsigned)w->walls[wall].id : (unsigned)w->bodies.slot[b] + 1,
                     overlap, (double)w->desc.overlap_stop);
}
static dem_result demi_member_part(dem_world *w) {
    if (!demi_list_drop(w)) return demi_no_memory(w, "dem_world_step");
    demi_surfaces_outdated(w);
    return DEM_OK;
}
/* Begins the motions that wait until the time of contact detection. Such a wall may leave a surface
   of walls at rest. After DEM_ERROR_MEMORY the next call tries again. */
static dem_result demi_motions_begin(dem_world *h) {
    dem_world *first = demi_member(h, 0);
    const int midway = demi_response_is(h, DEMI_MIDWAY);
    const double now = h->clock.time + midway*(double)h->clock.dt/2;
    int i, parts = 0;
    for (i = 0; i < first->wall_count; i++)
        if (first->walls[i].idle && !demi_wall_waits(&first->walls[i], now))
            parts |= demi_wall_parts(first, i) | 4;
    if (!parts) return DEM_OK;
    if (parts & 2 || (parts & 1 && h->team)) {
        const dem_result result = demi_all_agree(h, demi_member_part);
        demi_list_outdated(h);
        if (result != DEM_OK) return result;
    } else if (parts & 1) demi_facets_outdated(h);
    for (i = 0; i < first->wall_count; i++)
        first->walls[i].idle &= demi_wall_waits(&first->walls[i], now);
    return DEM_OK;
}
/* The part of a step after its move: 2 search, 3 to 5 forces. desc.overlap_stop and, with impulses,
   desc.unsolved_stops make a step fail that is complete; all members then agree that it is. */
static dem_result demi_step_answer(dem_world *h) {
    const uint64_t unsolved = h->booked.unsolved;
    dem_result result = demi_motions_begin(h);
    const int search = demi_list_due(h);
    if (result == DEM_OK && search) {
        result = demi_all_rebuild(h);
        if (result == DEM_OK && demi_outgrown(h)) demi_dt_outdated(h);
    }
    if (result == DEM_OK) result = demi_all_forces(h, !search && (!h->team || h->near_due));
    if (result == DEM_OK) result = demi_all(h, demi_member_end);
    if (result != DEM_OK) return result;
    h->stage.moved = 0;
    if (demi_member(h, 0)->desc.overlap_stop > 0) result = demi_all_agree(h, demi_member_crushed);
    if (result != DEM_OK) return result;
    if (!h->desc.unsolved_stops || h->booked.unsolved == unsolved) return DEM_OK;
    return demi_fail(h, DEM_ERROR_STOPPED, "dem_world_step: step %llu: %d sweeps left %.3g m/s, "
                     "more than the tolerance; %d of %d contacts are at their friction limit, %s; "
                     "allow more sweeps or a larger tolerance, take a smaller dt, or go on with "
                     "desc.unsolved_stops = 0", (unsigned long long)h->clock.steps,
                     h->booked.sweeps, h->booked.residual, h->solver.limited, h->solver.count,
                     2*h->solver.limited > h->solver.count ? "where sweeps converge slowly"
                     : "the others carry more load than so many sweeps pass on");
}
/* Calls a function at the positions of contact detection: the present ones, with the midpoint rule
   those half a step ahead. */
static dem_result demi_answer(dem_world *h, dem_result (*answer)(dem_world *h)) {
    dem_result result;
    if (!demi_response_is(h, DEMI_MIDWAY)) return answer(h);
    demi_ahead(h);
    result = answer(h);
    demi_ahead_back(h);
    return result;
}
/* Integrates user-defined numbers at the end of a step. A user's function for that receives
   complete velocities. */
static dem_result demi_member_gain(dem_world *w) {
    if (w->desc.body_reals_fn) demi_finish(w);
    demi_reals_gain(w);
    return DEM_OK;
}
/* Performs one step, or the rest of a step that ran out of memory after its move. */
static dem_result demi_step_once(dem_world *h) {
    dem_result result = DEM_OK;
    if (!h->stage.moved) {
        DEMI_PHASE(h, result, lead)
        if (result == DEM_OK) result = demi_all(h, demi_member_move);
        if (result == DEM_OK) result = demi_moved(h);
        if (result != DEM_OK) return result;
    }
    result = demi_step_lose(h);
    if (result == DEM_OK) result = demi_answer(h, demi_step_answer);
    if (!h->stage.moved && demi_member(h, 0)->bodies.real_count) demi_all(h, demi_member_gain);
    return result;
}

/* demi_refresh at the positions of contact detection. */
static dem_result demi_refresh_answer(dem_world *h) {
    dem_result result = demi_motions_begin(h);
    int stale = 0;
    if (result != DEM_OK) return result;
    if (h->stage.pairs_changed) {               /* half-step velocities belong to the old forces */
        demi_halves_outdated(h);
        if (!demi_list_drop(h)) return demi_no_memory(h, "dem_world_step");
    }
    stale = !h->stage.list_valid;
    if (stale) result = demi_all_rebuild(h);
    h->stage.pairs_changed = 0;
    if (result == DEM_OK) result = demi_all(h, demi_member_look);
    if (result == DEM_OK) result = demi_all_forces(h, !stale);
    if (result == DEM_OK) h->stage.list_valid = 1;      /* contacts can be read, if unstable too */
    if (result == DEM_OK) result = demi_all_agree(h, demi_member_looked);
    h->stage.forces_valid = result == DEM_OK;
    return result;
}
/* Computes the forces at the present time, because the scene has changed since the last step;
   rebuilds the lists if necessary. Contact histories stay as they are. */
static dem_result demi_refresh(dem_world *h) {
    const dem_result result = demi_all(h, demi_member_finish);
    return result == DEM_OK ? demi_answer(h, demi_refresh_answer) : result;
}

DEM_API dem_result dem_world_gravity_set(dem_world *w, dem_vec3 gravity) {
    if (demi_null(w, __func__, w, "world")) return DEM_ERROR_ARGUMENT;
    if (!demi_place(gravity))
        return demi_refuse(w, __func__, "gravity is (%g, %g, %g) m/s2, must be "
                           "finite and at most %g; check what it was computed from",
                           (double)gravity.x, (double)gravity.y, (double)gravity.z, DEMI_FARTHEST);
    demi_finish(w);                             /* the open half kick belongs to the old gravity */
    w->desc.gravity = gravity;
    if (w->desc.planar) w->desc.gravity.z = 0;
    demi_scene_changed(w);
    return DEM_OK;
}
DEM_API dem_result dem_world_dt_set(dem_world *w, dem_real dt) {
    if (demi_null(w, __func__, w, "world")) return DEM_ERROR_ARGUMENT;
    if (demi_dt_bad(dt))
        return demi_refuse(w, __func__, "dt is %g s, must be 0 or %g to %g s; 0 lets the "
                           "library choose", (double)dt, DEMI_DT_LEAST, DEMI_FARTHEST);
    if (!demi_response_is(w, DEMI_LASTING) && !(dt > 0))
        return demi_refuse(w, __func__, "dt is 0 s, but impulses have no contact time to "
                           "choose it from; set it, for example 1e-3 s for grains of millimetres");
    demi_finish(w);                             /* the open half kick belongs to the old dt */
    w->desc.dt = dt;
    demi_scene_changed(w);
    return DEM_OK;
}
/* Records replay frames and writes outputs that are due at this step. */
static dem_result demi_look(dem_world *w) {
    if (w->look.films_look) w->look.films_look(w);
    return w->look.outputs_look ? w->look.outputs_look(w) : DEM_OK;
}
/* Prepares a step: settles the time step, again after each feature that may change bodies, computes
   the forces of a scene that has changed, checks the time step against the present contacts, and
   sets half-step velocities. */
static dem_result demi_step_ready(dem_world *h) {
    dem_result result = demi_dt_settle(h);
    int k;
    for (k = 0; k < DEMI_FEATURES && result == DEM_OK; k++) {
        if (!demi_features[k].ready || !DEMI_FEATURE_ON(k, h)) continue;
        result = demi_features[k].ready(h);
        if (result == DEM_OK) result = demi_dt_settle(h);
    }
    if (result == DEM_OK && (!h->stage.forces_valid || h->stage.pairs_changed))
        result = demi_refresh(h);
    else if (result == DEM_OK && !h->stage.list_valid)
        result = demi_all_rebuild(h);           /* inserted grains touch nothing */
    if (result == DEM_OK) result = demi_dt_check(h);
    if (result == DEM_OK && !demi_bounded(h->clock.time + (double)h->clock.dt))
        result = demi_fail(h, DEM_ERROR_STOPPED, "dem_world_step: time is %g s and dt is %g s, "
                           "their sum must stay below %g s; was dt meant in another unit?",
                           h->clock.time, (double)h->clock.dt, DEMI_FARTHEST);
    if (result != DEM_OK || h->stage.primed) return result;
    h->stage.primed = 1;
    return demi_all(h, demi_member_prime);
}
/* Performs `steps` steps of all members, with replay frames and outputs between them. `call` names
   the public function in messages. */
static dem_result demi_steps(dem_world *h, const char *call, int steps) {
    /* not in the middle of a step: what is due there is written when the step is complete */
    int i, looks = (steps || h->clock.steps) && !h->stage.moved;
    dem_result result = looks && h->look.outputs_look ? demi_dt_settle(h) : DEM_OK;
    if (looks && result == DEM_OK) result = demi_look(h);
    for (i = 0; i < steps && result == DEM_OK; i++) {
        const demi_calling was = demi_calls(h, call, 1);
        demi_threads_begin(h);
        if (!h->stage.moved) result = demi_step_ready(h);
        if (result == DEM_OK) {
            result = demi_step_once(h);
            demi_threads_end(h);
            DEMI_PHASE(h, result, ended)
        }
        demi_called(h, was);
        if (result == DEM_OK) result = demi_events_tell(h, call);
        if (result == DEM_OK) result = demi_look(h);
    }
    if (result == DEM_OK) result = demi_agree(h, 0, 0);     /* failures of the last forces */
    if (!h->stage.moved) demi_all(h, demi_member_finish);
    return result;
}
DEM_API dem_result dem_world_step(dem_world *w, int steps) {
    if (demi_null(w, __func__, w, "world")) return DEM_ERROR_ARGUMENT;
    if (steps < 0) return demi_refuse(w, __func__, "steps is %d, must be >= 0", steps);
    if (steps && demi_unbuilt(w, __func__) != DEM_OK) return DEM_ERROR_ARGUMENT;
    if (w->look.under_way)
        return demi_refuse(w, __func__, "called from the function of an output "
                           "(dem_output_add), which runs between two steps and must not step the "
                           "world; step it when the run has ended");
    return demi_steps(w, __func__, steps);
}
