/* ---------------------------------------------------------------------------------------------
   >>step
   One step in the order of the manual, and runs of many. The parts of a step run over domains,
   in parallel, and wait for each other where one needs what another domain has done: after the
   move (who has come near?), after touch (had all contacts room?), after respond (forces that
   are fetched). A step begins where the one before ended its forces; its last half kick is left
   open until somebody looks (demi_finish), since the next step's first one is the same sum:
   velocities are touched once a step, not twice. What only a look needs, kinetic energy among
   it, is worked out at the look. Errors of a run are found in the step that caused them and name
   the body; a step that ran out of memory after its move is marked (stage.moved) and goes on
   from there.
   --------------------------------------------------------------------------------------------- */

/* How fast the fastest is, how much the most accelerated, and a sum that keeps what is not finite
   (a maximum loses it). In groups, each place of which has its own maximum and sum: that is what
   makes vectors of it. */
typedef struct demi_pace {
    dem_real speed2[DEMI_LANES], acceleration2[DEMI_LANES], sum[DEMI_LANES];
} demi_pace;
/* Maxima and a sum, per lane: the sum is not finite when any velocity is not. */
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
/* Moves some bodies, looks at their pace, clears their forces. */
static void demi_some_move(dem_world *w, demi_domain *domain, int begin, int end, int turning,
                           demi_pace *pace) {
    const size_t bytes = (size_t)(end - begin)*4*sizeof(dem_real);
    int i, l;
    if (w->bodies.booked && !w->stage.synced) demi_late_note(w, begin, end);
    demi_integrator_of(w)->advance(w, begin, end, turning);
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
/* The same for a domain in which some bodies may be quiet. */
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
/* J, of gravity in this step on the bodies of a domain: by their momentum, which rows of four sum
   together. (What does not move has no velocity.) */
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
/* All bodies of a domain, a few at a time; what is found on the way goes into the domain's sums. */
static void demi_domain_move(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    const int turning = demi_turns(w), some = 64;   /* these stay in the nearest cache */
    demi_pace pace;
    int i;
    memset(&pace, 0, sizeof pace);
    domain->speed2 = domain->acceleration2 = domain->check = 0;
    domain->turn = domain->turn_speed = domain->turn_rate = 0;
    if (demi_quiet_possible(w)) demi_quiet_move(w, d, turning, &pace);
    else for (i = domain->begin; i < domain->end; i += some)
        demi_some_move(w, domain, i, DEMI_MIN(i + some, domain->end), turning, &pace);
    for (i = 0; i < DEMI_LANES; i++) {
        domain->speed2 = DEMI_MAX(domain->speed2, (double)pace.speed2[i]);
        domain->acceleration2 = DEMI_MAX(domain->acceleration2, (double)pace.acceleration2[i]);
        domain->check += (double)pace.sum[i];
    }
    /* where contacts are found, bodies have gone with the velocity of the end of the step */
    for (i = domain->begin; i < domain->end && demi_response_is(w, DEMI_MIDWAY); i++) {
        const dem_vec3 v = demi_at(w->bodies.vel + 4*i);
        domain->speed2 = DEMI_MAX(domain->speed2, (double)demi_dot(v, v));
    }
    if (w->desc.ledger) domain->energy[DEMI_E_GRAVITY] = demi_gravity_work(w, domain);
}

/* Time and velocities that fields of force see: of now, or with the midpoint rule in the middle of
   the next step, if velocities go on as in the last one. */
static double demi_field_time(const dem_world *w) {
    return w->clock.time + (demi_response_is(w, DEMI_MIDWAY) ? (double)w->clock.dt/2 : 0);
}
DEM_INLINE dem_vec3 demi_field_rate(const dem_world *w, const dem_real *now, const dem_real *half,
                                    int i) {
    const dem_vec3 v = demi_at(now + 4*i);
    return demi_response_is(w, DEMI_MIDWAY) ? demi_sub(demi_scale(v, 2), demi_at(half + 4*i)) : v;
}
/* Forces and torques of a field that sees whole bodies. */
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
        w->desc.body_force(&body, id, demi_field_time(w), &force, &torque, w->desc.force_user);
        demi_force_add(w->bodies.force + 4*i, force);
        demi_force_add(w->bodies.torque + 4*i, torque);
        if (w->desc.ledger && w->stage.forces_valid && w->bodies.inv_mass[i] > 0)
            domain->energy[DEMI_E_FORCE] += (double)(demi_dot(force, body.velocity) +
                                                     demi_dot(torque,
                                                              body.spin))*(double)w->clock.dt;
    }
}
/* Force field, or nothing, to start the sums with; after a move forces are clear already. */
static void demi_domain_clear(dem_world *w, int d) {
    const demi_domain *domain = &w->domains[d];
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
        const dem_vec3 f = w->desc.force(demi_at(w->bodies.pos + 4*i), v, w->bodies.pos[4*i + 3],
                                         w->bodies.mass[i], demi_field_time(w),
                                         w->desc.force_user);
        demi_put(w->bodies.force + 4*i, f);
        if (w->desc.ledger && w->stage.forces_valid && w->bodies.inv_mass[i] > 0)
            w->domains[d].energy[DEMI_E_FORCE] += (double)demi_dot(f, v)*(double)w->clock.dt;
    }
    if (w->desc.body_force) demi_domain_fields(w, d);
}
/* All contacts that a domain owns. Its own bodies are summed here; forces on bodies of other
   domains stay in slots until all have answered (demi_cross_gather). */
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
/* What others did to this domain's bodies, in the order of their entries. */
static void demi_domain_gather(dem_world *w, int d) {
    int i;
    if (w->cross_entries && demi_responses[w->desc.response].respond) demi_cross_gather(w, d);
    if (demi_own(w)) {                          /* those of your own may answer anything */
        double sum = 0;
        for (i = 4*w->domains[d].begin; i < 4*w->domains[d].end; i++)
            sum += fabs((double)w->bodies.force[i]) + fabs((double)w->bodies.torque[i]);
        for (i = w->bodies.real_count*w->domains[d].begin;
             i < w->bodies.real_count*w->domains[d].end; i++)
            sum += fabs((double)w->bodies.rates[i]) + fabs((double)w->bodies.reals[i]);
        w->domains[d].check = sum;
    }
    if (!w->desc.planar) return;
    /* nothing pushes a disc out of its plane */
    for (i = w->domains[d].begin; i < w->domains[d].end; i++)
        w->bodies.force[4*i + 2] = w->bodies.torque[4*i] = w->bodies.torque[4*i + 1] = 0;
}
/* What walls gain of the user's numbers per second: domains in order, as above. */
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
/* Forces at the present positions and velocities; wall loads. 0: memory ran out. */
static int demi_forces(dem_world *w) {
    const double dt = w->stage.forces_valid ? (double)w->clock.dt : 0;
    const demi_response_row *response = &demi_responses[w->desc.response];
    demi_kept *kept = w->kept_now;
    int d, i, k;
    if (response->room && !response->room(w)) return 0;
    for (d = 0; d < w->domain_count; d++) {
        w->domains[d].overlap = 0;
        for (i = 0; i < DEMI_ENERGIES; i++) w->domains[d].energy[i] = 0;
    }
    demi_parallel(w, w->desc.threads, w->domain_count, demi_domain_respond);
    if (response->solve) response->solve(w);
    demi_parallel(w, w->desc.threads, w->domain_count, demi_domain_gather);
    w->kept_now = w->kept_next;
    w->kept_next = kept;
    for (d = 0; d < w->domain_count; d++) w->domains[d].kept = w->domains[d].kept_next;
    for (i = 0; i < w->wall_count; i++) {  /* domains in order: one order whatever the threads */
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
        for (k = 0; k < 3; k++) c->impulse[k] += f[k]*dt;
        c->torque_impulse += (double)c->torque_axial*dt;
        c->work += power*dt;
        c->time += dt;
    }
    if (demi_exchanges(w)) demi_walls_rates(w);
    for (d = 0; d < w->domain_count; d++)
        w->booked.overlap_max = DEMI_MAX(w->booked.overlap_max, w->domains[d].overlap);
    if (w->material_count == 1 && w->booked.overlap_max > 0) w->booked.met[0] = 1;
    response->book(w);
    return 1;
}

/* Which two bodies overlap most, of the smaller radius. Answers by how much. */
static double demi_deepest_pair(const dem_world *w, int *first, int *second) {
    double most = 0;
    int d, k;
    for (d = 0; d < w->domain_count; d++) {
        const demi_domain *domain = &w->domains[d];
        const demi_kept *kept = demi_kept_of(w, d);
        for (k = 0; k < domain->near_end; k++) {
            const int at = d*w->near.stride + k, a = w->near.a[at], b = w->near.b[at];
            const dem_real p = w->bodies.pos[4*a + 3], q = w->bodies.pos[4*b + 3];
            const dem_real way = demi_length(demi_near_way(w, (size_t)at));
            const double deep = (double)((p + q - way)/DEMI_MIN(p, q));
            if (k >= domain->near_own && k < domain->near_cross) continue;
            if (deep > most) { most = deep; *first = a; *second = b; }
        }
        for (k = 0; k < domain->kept; k++)
            if (kept[k].b >= 0 && (double)kept[k].deep > most) {
                most = (double)kept[k].deep;
                *first = kept[k].a;
                *second = kept[k].b;
            }
    }
    return most;
}

/* Names the body that went wrong. */
static dem_result demi_unstable(dem_world *w) {
    int i, d, first = 0, second = 0;
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
    for (d = 0; d < w->domain_count; d++)
        for (i = 0; i < w->domains[d].kept; i++) {
            const demi_kept *c = demi_kept_of(w, d) + i;
            if (c->b < 0 && c->deep >= 1)
                return demi_fail(w, DEM_ERROR_UNSTABLE, "dem_world_step: step %llu, body %u "
                                 "overlaps wall %d by %.3g of its "
                                 "radius, must be below 1; it started inside the wall, hit it too "
                                 "fast for dt = %g s, or the "
                                 "material is too soft", (unsigned long long)w->clock.steps,
                                 (unsigned)w->bodies.slot[c->a] + 1, (int)w->walls[c->wall].id,
                                 (double)c->deep, (double)w->clock.dt);
        }
    deepest = demi_deepest_pair(w, &first, &second);
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
    return demi_fail(w, DEM_ERROR_UNSTABLE, "dem_world_step: step %llu: bodies %u and %u overlap "
                     "by %.3g of the smaller radius, must be below 1; they started inside each "
                     "other, collided too fast for dt = %g s, or the material is too soft",
                     (unsigned long long)w->clock.steps, (unsigned)w->bodies.slot[first] + 1,
                     (unsigned)w->bodies.slot[second] + 1, deepest, (double)w->clock.dt);
}

/* Bodies whose centre left through an outflow boundary are taken out. */
static dem_result demi_outflow(dem_world *w) {
    double lo[3], hi[3];
    int i, k, any = 0;
    demi_domain_limits(w, lo, hi);
    for (k = 0; k < 3; k++) any |= w->desc.boundary[k] == DEM_BOUNDARY_OUTFLOW;
    if (!any) return DEM_OK;
    for (i = 0; i < w->bodies.count; i++)
        for (k = 0; k < 3; k++) {
            const double x = (double)w->bodies.pos[4*i + k];
            if (w->desc.boundary[k] != DEM_BOUNDARY_OUTFLOW || (x >= lo[k] && x <= hi[k])) continue;
            if (!demi_list_drop(w)) return demi_no_memory(w, "dem_world_step");
            demi_body_take_out(w, i--);
            w->bodies.balance.left++;
            break;
        }
    return DEM_OK;
}

/* Time after one more step. */
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
/* 1 move: first half kick, drift, predicted velocities; walls follow. */
static dem_result demi_step_move(dem_world *w) {
    double speed2 = 0, acceleration2 = 0, turn = 0, turn_speed = 0, turn_rate = 0;
    int d, i;
    w->clock.half_kick = (double)w->clock.dt/2;
    demi_parallel(w, w->desc.threads, w->domain_count, demi_domain_move);
    w->stage.synced = demi_response_is(w, DEMI_MIDWAY);
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
    /* series end there */
    if (sqrt(turn_rate)*(double)w->clock.dt > (w->desc.allow_large_dt ? 2 : 1))
        return demi_spins_refuse(w, sqrt(turn_rate), "dem_world_step");
    w->booked.speed_max = sqrt(speed2);
    w->margin.step_gone =
        (w->booked.speed_max + (w->effects.tight ? sqrt(turn_speed) : 0))*(double)w->clock.dt;
    w->margin.gone += w->margin.step_gone;
    w->margin.last_change = sqrt(acceleration2)*(double)w->clock.dt + sqrt(turn);
    if (w->desc.ledger) {
        const double work = demi_sum_energy(w, DEMI_E_GRAVITY);
        w->booked.energy[DEMI_E_GRAVITY] += work;
        w->booked.throughput += fabs(work);
        demi_due_book(w);
    }
    for (i = 0; i < w->wall_count; i++) {
        demi_wall *wall = &w->walls[i];
        dem_pose pose = wall->pose, mid = wall->mid;
        double speed;
        if (wall->kind == DEMI_WALL_NONE || wall->motion.kind == DEM_MOTION_FIXED) continue;
        demi_wall_pose_at(wall, w->clock.time, &pose);
        if (!demi_response_is(w, DEMI_MIDWAY))
            demi_wall_pose_at(wall, w->clock.time - w->clock.half_kick, &mid);
        if (!demi_pose_sane(&pose) || !demi_pose_sane(&mid)) {
            w->stage.forces_valid = 0;          /* the wall stays where it was, finite */
            w->margin.walls_gone = 1e300;
            return demi_fail(w, DEM_ERROR_UNSTABLE, "dem_world_step: step %llu: the motion of "
                             "wall %d gave a pose that is not finite, whose matrix is not a "
                             "rotation, or that is beyond %g m, m/s or rad/s at %g s; check the "
                             "motion", (unsigned long long)w->clock.steps, i + 1, DEMI_FARTHEST,
                             w->clock.time);
        }
        wall->pose = pose;
        wall->mid = mid;
        speed = demi_wall_speed(wall);
        if (speed < 0) w->margin.walls_gone = 1e300;   /* no bound: look anew */
        else w->wall_fastest = DEMI_MAX(w->wall_fastest, speed);
    }
    w->margin.walls_gone += w->wall_fastest*(double)w->clock.dt;
    w->wall_fastest = 0;
    return DEM_OK;
}

/* Largest overlap of the forces just worked out, over the smaller radius. */
static double demi_overlap(const dem_world *w) {
    double overlap = 0;
    int d;
    for (d = 0; d < w->domain_count; d++) overlap = DEMI_MAX(overlap, w->domains[d].overlap);
    return overlap;
}

/* The user's numbers of a domain's bodies follow the rates of the step. */
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
            w->desc.body_reals_fn(reals, rates, &body, id, w->clock.time, dt,
                                  w->desc.body_reals_user);
    }
}
/* After the forces of a step, not where they are only looked at: what the user's numbers gain. */
static void demi_reals_gain(dem_world *w) {
    int i, k;
    if (!w->bodies.real_count) return;
    demi_parallel(w, w->desc.threads, w->domain_count, demi_domain_gain);
    for (i = 0; i < w->wall_count; i++)
        for (k = 0; k < w->bodies.real_count; k++)
            w->walls[i].loads.gained[k] += w->walls[i].loads.rate[k]*(double)w->clock.dt;
}
/* A step from its second part on. Numbers as in the manual. */
static dem_result demi_step_answer(dem_world *w) {
    const uint64_t unsolved = w->booked.unsolved;
    dem_result result;
    int d, search;
    /* 2 search: when something may have come near that is not in the list. Outlets look then:
       nobody gets farther than half a skin between two lists */
    result = demi_outflow(w);
    search = !w->stage.list_valid || w->margin.skin <= 0 || 2*w->margin.gone > w->margin.skin ||
             w->margin.gone + w->margin.walls_gone > w->margin.skin;
    if (result == DEM_OK && w->outlet_count && (search || w->clock.steps%DEMI_OUTLET_REST == 0))
        result = demi_outlets_run(w);
    if (result != DEM_OK) return result;
    if (search || !w->stage.list_valid) {
        result = demi_rebuild(w, "dem_world_step");
        if (result != DEM_OK) return result;
        demi_kernel_choose(w);
        if (demi_outgrown(w)) w->stage.dt_valid = 0;
    } else if (w->stage.near_stale || demi_near_due(w)) {
        if (!w->stage.near_chosen && demi_near_due(w)) demi_near_choose(w);
        w->stage.near_chosen = 1;
        if (!demi_near_make(w, 0)) return demi_no_memory(w, "dem_world_step");
        w->stage.near_chosen = 0;
    }

    /* 3 touch, 4 respond, 5 gather */
    if (!demi_touch(w) || !demi_forces(w)) return demi_no_memory(w, "dem_world_step");
    demi_reals_gain(w);
    w->stage.moved = 0;
    for (d = 0; d < w->domain_count && demi_own(w); d++)
        if (!(w->domains[d].check < 1e300)) return demi_unstable(w);

    /* 6 kick: the second half kick waits until somebody looks or the next step begins (demi_finish)
       */
    if (!(demi_overlap(w) < 1)) return demi_unstable(w);
    if (!w->desc.unsolved_stops || w->booked.unsolved == unsolved) return DEM_OK;
    return demi_fail(w, DEM_ERROR_STOPPED, "dem_world_step: step %llu: %d sweeps left %.3g m/s, "
                     "more than the tolerance; %d of %d contacts are at their friction limit, %s; "
                     "allow more sweeps or a larger tolerance, take a smaller dt, or go on with "
                     "desc.unsolved_stops = 0", (unsigned long long)w->clock.steps,
                     w->booked.sweeps, w->booked.residual, w->solver.limited, w->solver.count,
                     2*w->solver.limited > w->solver.count ? "where sweeps converge slowly"
                     : "the others carry more load than so many sweeps pass on");
}
/* The same where contacts are found: with the midpoint rule half a step ahead. */
static dem_result demi_answer(dem_world *w, dem_result (*answer)(dem_world *w)) {
    dem_result result;
    if (!demi_response_is(w, DEMI_MIDWAY)) return answer(w);
    demi_ahead(w);
    result = answer(w);
    demi_ahead_back(w);
    return result;
}
/* One step. One that ran out of memory after its move goes on from there. */
static dem_result demi_step_once(dem_world *w) {
    if (!w->stage.moved) {
        const dem_result result = demi_step_move(w);
        if (result != DEM_OK) return result;
        demi_near_pass(w, w->margin.last_change);
        w->stage.moved = 1;
    }
    return demi_answer(w, demi_step_answer);
}

static dem_result demi_refresh_answer(dem_world *w) {
    dem_result result;
    if (w->stage.pairs_changed) {               /* half steps were of the old forces, and effects */
        w->stage.primed = 0;
        if (!demi_list_drop(w)) return demi_no_memory(w, "dem_world_step");
    }
    if (!w->stage.list_valid) {
        result = demi_rebuild(w, "dem_world_step");
        if (result != DEM_OK) return result;
    }
    w->stage.pairs_changed = 0;
    demi_kernel_choose(w);
    w->stage.forces_valid = 0;
    if (!demi_touch(w) || !demi_forces(w)) return demi_no_memory(w, "dem_world_step");
    if (!(demi_overlap(w) < 1)) return demi_unstable(w);
    w->stage.forces_valid = 1;
    return DEM_OK;
}
/* Something changed since the last step: forces at t, by a new list if need be; memory stays. */
static dem_result demi_refresh(dem_world *w) {
    demi_finish(w);
    return demi_answer(w, demi_refresh_answer);
}

DEM_API dem_result dem_world_gravity_set(dem_world *w, dem_vec3 gravity) {
    if (demi_null(w, "dem_world_gravity_set", w, "world")) return DEM_ERROR_ARGUMENT;
    if (!demi_place(gravity))
        return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_world_gravity_set: gravity is (%g, %g, %g) "
                         "m/s2, must be finite and at most %g; check what it was computed from",
                         (double)gravity.x, (double)gravity.y, (double)gravity.z, DEMI_FARTHEST);
    demi_finish(w);                             /* the half kick that is due is of the old one */
    w->desc.gravity = gravity;
    if (w->desc.planar) w->desc.gravity.z = 0;
    demi_scene_changed(w);
    return DEM_OK;
}
DEM_API dem_result dem_world_dt_set(dem_world *w, dem_real dt) {
    if (demi_null(w, "dem_world_dt_set", w, "world")) return DEM_ERROR_ARGUMENT;
    if (demi_dt_bad(dt))
        return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_world_dt_set: dt is %g s, must be 0 or %g to "
                         "%g s; 0 lets the library choose", (double)dt, DEMI_DT_LEAST,
                         DEMI_FARTHEST);
    if (!demi_response_is(w, DEMI_LASTING) && !(dt > 0))
        return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_world_dt_set: dt is 0 s, but impulses have "
                         "no contact time to choose it from; set it, for example 1e-3 s for "
                         "grains of millimetres");
    demi_finish(w);                             /* half steps were of the old one */
    w->desc.dt = dt;
    demi_scene_changed(w);
    return DEM_OK;
}
/* Films and outputs that are due at this step. */
static dem_result demi_look(dem_world *w) {
    if (w->look.films_look) w->look.films_look(w);
    return w->look.outputs_look ? w->look.outputs_look(w) : DEM_OK;
}
/* Before a step: its dt, new grains, forces of a scene that has changed. */
static dem_result demi_step_ready(dem_world *w) {
    dem_result result = demi_dt_settle(w);
    if (result == DEM_OK && w->feed_count) {
        result = demi_world_feed(w);
        if (result == DEM_OK) result = demi_dt_settle(w);   /* there may be new grains */
    }
    if (result == DEM_OK &&
        (!w->stage.forces_valid || !w->stage.list_valid || w->stage.pairs_changed))
        result = demi_refresh(w);
    if (result == DEM_OK) result = demi_dt_check(w);
    if (result == DEM_OK && !demi_bounded(w->clock.time + (double)w->clock.dt))
        result = demi_fail(w, DEM_ERROR_STOPPED, "dem_world_step: time is %g s and dt is %g s, "
                           "their sum must stay below %g s; was dt meant in another unit?",
                           w->clock.time, (double)w->clock.dt, DEMI_FARTHEST);
    if (result == DEM_OK && !w->stage.primed) { demi_finish(w); demi_prime(w); }
    return result;
}
DEM_API dem_result dem_world_step(dem_world *w, int steps) {
    if (demi_null(w, "dem_world_step", w, "world")) return DEM_ERROR_ARGUMENT;
    dem_result result = DEM_OK;
    demi_calling was;
    int i, whole = 1;
    if (steps < 0)
        return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_world_step: steps is %d, must be >= 0", steps);
    if (steps && demi_unbuilt(w, "dem_world_step") != DEM_OK) return DEM_ERROR_ARGUMENT;
    if (w->look.under_way)
        return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_world_step: called from the function of an "
                         "output (dem_output_add), which runs between two steps and must not step "
                         "the world; step it when the run has ended");
    if (steps) result = demi_look(w);
    for (i = 0; i < steps && result == DEM_OK; i++) {
        was = demi_calls(w, "dem_world_step", 1);
        if (!w->stage.moved) result = demi_step_ready(w);
        if (result == DEM_OK) {
            result = demi_step_once(w);
            whole = result == DEM_OK;
            if (whole) demi_fields_sample(w);
        }
        w->look.calling = was;
        if (result == DEM_OK) result = demi_look(w);
    }
    /* half a step: its velocities stay as predicted */
    if (!whole && w->stage.moved) return result;
    demi_finish(w);
    return result;
}

/* Asks the user's progress function, if any. `since`: s of wall time when the call began. */
static dem_result demi_progress(dem_world *w, const char *call, dem_progress_fn progress,
                                void *user, double done, double since) {
    const double left = (demi_clock() - since)*(1 - done)/DEMI_MAX(done, 1e-9);
    const demi_calling was = demi_calls(w, call, 0);
    const int stop = progress && progress(w, done, done < 1 ? left : 0, user) && done < 1;
    w->look.calling = was;
    return stop ? demi_fail(w, DEM_ERROR_STOPPED, "%s: stopped by the progress function at %g s",
                            call, w->clock.time) : DEM_OK;
}
DEM_API dem_result dem_world_run(dem_world *w, double seconds, dem_progress_fn progress,
                                 void *user) {
    if (demi_null(w, "dem_world_run", w, "world")) return DEM_ERROR_ARGUMENT;
    const double start = w->clock.time, begun = demi_clock();
    double last = begun, end;
    int chunk = 1;
    if (!demi_finite_double(seconds) || !(seconds >= 0) || !(seconds < 1e300))
        return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_world_run: seconds is %g, must be finite and "
                         ">= 0", seconds);
    if (demi_unbuilt(w, "dem_world_run") != DEM_OK) return DEM_ERROR_ARGUMENT;
    if (progress) w->look.tenths_told = 0;      /* dem_world_settle tells for several runs */
    end = start + seconds;
    if (w->clock.run_steps == w->clock.steps &&
        fabs(w->clock.run_end - start) <= (double)w->clock.dt)
        end = w->clock.run_end + seconds;
    for (;;) {
        const double left = end - w->clock.time;
        double now;
        int steps = chunk;
        dem_result result = demi_dt_settle(w);
        if (result != DEM_OK) return result;
        if (left < (double)w->clock.dt/2) break;
        if (left/(double)w->clock.dt < chunk) steps = (int)(left/(double)w->clock.dt + 0.5);
        if (steps < 1) steps = 1;
        result = dem_world_step(w, steps);
        if (result != DEM_OK) return result;
        now = demi_clock();
        if (now - last > 0.1) {
            last = now;
            result = demi_progress(w, "dem_world_run", progress, user,
                                   (w->clock.time - start)/seconds, begun);
            if (result != DEM_OK) return result;
        }
        /* short steps: look at the clock less often */
        if (now - begun < 0.05*(double)w->clock.steps && chunk < 1000) chunk++;
    }
    w->clock.run_end = end;
    w->clock.run_steps = w->clock.steps;
    return demi_progress(w, "dem_world_run", progress, user, 1, begun);
}

DEM_API dem_result dem_world_run_to(dem_world *w, double time, dem_progress_fn progress,
                                    void *user) {
    if (demi_null(w, "dem_world_run_to", w, "world")) return DEM_ERROR_ARGUMENT;
    if (!demi_finite_double(time) || time < w->clock.time - (double)w->clock.dt/2)
        return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_world_run_to: time is %g s, must be finite "
                         "and not before now (%g s); to go back in time, read a checkpoint", time,
                         w->clock.time);
    w->clock.run_steps = w->clock.steps + 1;        /* it does not follow the run before */
    return dem_world_run(w, DEMI_MAX(time - w->clock.time, 0), progress, user);
}

/* m/s: largest speed of the bodies that can move, and the root of the mean of its square. */
static double demi_speeds(const dem_world *w, double *mean) {
    double sum = 0, most = 0, mass = 0;
    int i;
    for (i = 0; i < w->bodies.count; i++) {
        const dem_vec3 v = demi_at(w->bodies.vel + 4*i);
        const double vv = (double)demi_dot(v, v), m = (double)w->bodies.mass[i];
        if (!(w->bodies.inv_mass[i] > 0)) continue;
        sum += m*vv;
        mass += m;
        most = DEMI_MAX(most, vv);
    }
    *mean = mass > 0 ? sqrt(sum/mass) : 0;
    return sqrt(most);
}
/* m/s, the speed at rest: `speed`, or where that is 0 a hundredth of a fall by a mean radius.
   *look: s, the time to fall by half a radius, or to go that far: a body that turns round is not at
   rest. */
static double demi_calm(const dem_world *w, double speed, double *look) {
    const double g = (double)demi_length(w->desc.gravity);
    double radius = w->feed_count ? demi_feed_at(w, 0)->lo[0] : 0;      /* of the first to come */
    int i;
    if (w->bodies.count) radius = 0;
    for (i = 0; i < w->bodies.count; i++)
        radius += (double)w->bodies.pos[4*i + 3]/w->bodies.count;
    if (!(speed > 0) && g > 0) speed = 0.01*sqrt(2*g*radius);
    *look = g > 0 ? sqrt(radius/g) : radius/2/DEMI_MAX(speed, 1e-300);
    return speed;
}
/* The first feed that still brings grains; -1: none does. */
static int demi_feed_coming(const dem_world *w) {
    int i = 0;
    while (i < w->feed_count && demi_feed_at(w, i)->state.done) i++;
    return i < w->feed_count ? i : -1;
}
/* Time is up: why the bodies are not at rest. */
static dem_result demi_unsettled(dem_world *w, double seconds, double below) {
    const int i = demi_feed_coming(w);
    double mean, most = demi_speeds(w, &mean);
    if (i >= 0) {
        const dem_feed_state *f = &demi_feed_at(w, i)->state;
        return demi_fail(w, DEM_ERROR_STOPPED, "dem_world_settle: not at rest after %g s: feed %d "
                         "is not done (%llu grains inserted, %llu waiting for room), and grains "
                         "can rest only when it is; allow more time, a higher rate or a larger box",
                         seconds, i + 1, (unsigned long long)f->total,
                         (unsigned long long)f->waiting);
    }
    return demi_fail(w, DEM_ERROR_STOPPED, "dem_world_settle: not at rest after %g s: mean speed "
                     "%.3g m/s, largest %.3g m/s, must be below %.3g and %.3g; allow more time, "
                     "or find what drives the grains", seconds, mean, most, below, 10*below);
}
DEM_API dem_result dem_world_settle(dem_world *w, double seconds, dem_real speed,
                                    dem_progress_fn progress, void *user) {
    if (demi_null(w, "dem_world_settle", w, "world")) return DEM_ERROR_ARGUMENT;
    const double begun = demi_clock(), start = w->clock.time;
    double look, below = demi_calm(w, (double)speed, &look), last = begun;
    int i, calm = 0;
    if (!demi_finite_double(seconds) || !(seconds > 0) || !(speed >= 0) || !demi_finite(speed) ||
        (!(below > 0) && (w->bodies.count || demi_feed_coming(w) >= 0)))
        return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_world_settle: seconds is %g and speed is %g "
                         "m/s; seconds must be > 0, speed >= 0, and > 0 without gravity, from "
                         "which the default follows; set the speed that counts as rest", seconds,
                         (double)speed);
    for (i = 0; i < w->feed_count; i++) {
        const demi_feed *f = demi_feed_at(w, i);
        if (!f->desc.limited && !(f->desc.end > 0))
            return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_world_settle: feed %d has limited 0 and "
                             "end 0 s, one of them must be > 0, or the feed never ends; set one "
                             "of them, or use dem_world_run", i + 1);
    }
    w->look.tenths_told = 0;
    while (w->bodies.count || demi_feed_coming(w) >= 0) {
        const double left = start + seconds - w->clock.time;
        double mean, most = demi_speeds(w, &mean);
        dem_result result;
        below = demi_calm(w, (double)speed, &look);
        calm = demi_feed_coming(w) < 0 && mean < below && most < 10*below ? calm + 1 : 0;
        if (calm > 2) break;
        if (!(left > (double)w->clock.dt/2)) return demi_unsettled(w, seconds, below);
        look = DEMI_MAX(DEMI_MIN(look, seconds/4), (double)w->clock.dt);
        result = dem_world_run(w, DEMI_MIN(look, left), 0, 0);
        if (result != DEM_OK) return result;
        if (demi_clock() - last > 0.1) {
            last = demi_clock();
            result = demi_progress(w, "dem_world_settle", progress, user,
                                   (w->clock.time - start)/seconds, begun);
            if (result != DEM_OK) return result;
        }
    }
    return demi_progress(w, "dem_world_settle", progress, user, 1, begun);
}

/* Is this a terminal? C has no word for that: asked as readlink is (>>write). Elsewhere: yes. */
#if (defined(__unix__) || defined(__linux__)) && (defined(__GNUC__) || defined(__TINYC__)) && \
    !defined(__CYGWIN__)
int demi_isatty(int file) __asm__("isatty");
int demi_fileno(FILE *file) __asm__("fileno");
#elif defined(__APPLE__) && defined(__GNUC__)
int demi_isatty(int file) __asm__("_isatty");
int demi_fileno(FILE *file) __asm__("_fileno");
#else
static int demi_isatty(int file) { (void)file; return 1; }
static int demi_fileno(FILE *file) { (void)file; return 0; }
#endif
DEM_API int dem_progress_print(const dem_world *w, double done, double seconds_left, void *user) {
    if (demi_null_look(w, "dem_progress_print", user, "user")) return 0;
    FILE *out = (FILE *)user;
    const int line = !demi_isatty(demi_fileno(out)), tenths = (int)(10*done + 1e-9);
    if (line && tenths <= w->look.tenths_told) return 0;
    ((dem_world *)w)->look.tenths_told = tenths;
    fprintf(out, "%s%5.1f %%  t = %-10.4g s  %d grains  %.0f s left   ", line ? "" : "\r",
            100*done, w->clock.time, w->bodies.count, seconds_left);
    if (w->booked.unsolved)
        fprintf(out, "%llu steps above the tolerance   ",
                (unsigned long long)w->booked.unsolved);
    if (line || done >= 1) fputc('\n', out);
    fflush(out);
    return 0;
}

DEM_API double dem_world_time_get(const dem_world *w) {
    if (demi_null_look(w, "dem_world_time_get", w, "world")) return 0;
    return w->clock.time;
}
DEM_API uint64_t dem_world_steps_get(const dem_world *w) {
    if (demi_null_look(w, "dem_world_steps_get", w, "world")) return 0;
    return w->clock.steps;
}
