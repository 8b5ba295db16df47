/* ---------------------------------------------------------------------------------------------
   >>impulses-told
   Application of the solved impulses: forces of the coming step (on bodies, on walls and in
   output), contact history and energy losses. Part of the remaining overlap is corrected by
   displacements that leave velocities unchanged. Also contact detection half a step ahead. Calls
   the solver of >>solvers; writes forces of bodies, loads of walls and the energies due in
   w->booked.
   --------------------------------------------------------------------------------------------- */

/* Sets the time step to desc.dt: rigid contacts have no duration that would limit it. Fails if
   polyhedra would not rest with it, or if the solver does not support the rolling or spinning
   friction or the joints of the scene. */
static dem_result demi_impulses_settle(dem_world *w) {
    const demi_solver_row *solver = &demi_solvers[w->desc.solver];
    const double most = w->desc.allow_large_dt ? 0 : demi_rest_limit(w);
    if (most > 0 && (double)w->desc.dt > most)
        return demi_fail(w, DEM_ERROR_TIME_STEP, "dem_world_step: dt is %g s, must be at most %.3g "
                         "s for polyhedra as small as these to rest on each other under gravity; "
                         "use at most %.2g s", (double)w->desc.dt, most, most/1.5);
    if (demi_impulses_twist(w) && !solver->moments)
        return demi_refuse(w, "dem_world_step", "materials have rolling or spinning friction, "
                           "which the solver %s does not support; leave desc.solver at "
                           "DEM_SOLVER_GAUSS_SEIDEL", solver->name);
    if (demi_joints_in_force(w) && !solver->joints)
        return demi_refuse(w, "dem_world_step", "there are joints, which the solver %s does not "
                           "support; leave desc.solver at DEM_SOLVER_GAUSS_SEIDEL", solver->name);
    w->clock.dt = w->desc.dt;
    demi_dt_settled(w);
    return DEM_OK;
}
/* Allocates the arrays of the solver for all contacts that are possible in this step. Returns 0 if
   memory ran out. */
static int demi_impulses_room(dem_world *w) {
    demi_solver *s = &w->solver;
    const demi_solver_row *solver = &demi_solvers[w->desc.solver];
    const size_t bodies = (size_t)w->bodies.count;
    size_t movers = bodies + (size_t)w->persistent_first[DEMI_DOMAINS], n = 0;
    int d;
    if (!demi_joints_room(w)) return 0;
    movers += (size_t)w->joint_count;
    s->mover_count = (int)movers;
    for (d = 0; d < w->domain_count; d++) {
        s->meeting_first[d] = (int)n;
        n += (size_t)(w->domains[d].near_end + w->domains[d].persistent_next);
    }
    s->twisted = demi_impulses_twist(w);
    return DEMI_GROW(w, s->meetings, n) && DEMI_GROW(w, s->contacts, n) &&
        DEMI_GROW(w, s->beside, n) && DEMI_GROW(w, s->runs, n/DEMI_SWEEP_RUN + DEMI_COLOURS) &&
        DEMI_GROW(w, s->movers, (size_t)solver->copies*movers) &&
        DEMI_GROW(w, s->colours, bodies) && DEMI_GROW(w, s->lifts, 4*bodies) &&
        (!s->twisted || DEMI_GROW(w, s->twists, n)) &&
        DEMI_GROW(w, s->vectors, (size_t)solver->vectors*n) && DEMI_GROW(w, s->degrees, bodies) &&
        (!w->bodies.shaped ||
         (DEMI_GROW(w, s->arms, 2*n) && DEMI_GROW(w, s->tensors, 6*bodies) &&
          DEMI_GROW(w, s->seats, n/3 + 1) && DEMI_GROW(w, s->trees, bodies) &&
          DEMI_GROW(w, s->treed, bodies)));
}
/* Correction of the remaining overlap. Lifts are pseudo-velocities, m/s: they displace bodies in
   this step and are then discarded, so they add no kinetic energy. They do not rotate bodies. A
   contact's own lift, kg m/s, is an impulse >= 0, found by projected Gauss-Seidel, to the tolerance
   of the velocities. */
enum { DEMI_LIFTS = 5 };                        /* least number of sweeps, if anything is lifted */
#define DEMI_LIFTED DEM_R(0.2)                  /* part of an overlap corrected per step */
static void demi_impulses_lift(dem_world *w, int index) {
    demi_solver *s = &w->solver;
    demi_run_sums sums = {0, 0, 0, 0};
    int i, end;
    for (demi_run_bounds(s, index, &i, &end); i < end; i++) {
        const demi_impulse *c = s->contacts + i;
        const dem_real ia = s->movers[c->a].inv, ib = s->movers[c->b].inv;
        demi_beside *beside = s->beside + i;
        dem_real *la = s->lifts + 4*c->a, *lb = ib > 0 ? s->lifts + 4*c->b : 0;
        const dem_vec3 a = ia > 0 ? demi_at(la) : demi_v(0, 0, 0), n = c->normal;
        const dem_vec3 b = lb ? demi_at(lb) : demi_v(0, 0, 0);
        const dem_real part = beside->gap < 0 ? DEMI_LIFTED*beside->gap : beside->gap;
        const dem_real want = beside->lift -
            (demi_dot(demi_sub(b, a), n) + part/s->dt)*beside->mass;
        const dem_real lift = DEMI_MAX(want, 0), by = lift - beside->lift;
        beside->lift = lift;
        if (ia > 0) demi_put(la, demi_sub(a, demi_scale(n, by*ia)));
        if (lb) demi_put(lb, demi_add(b, demi_scale(n, by*ib)));
        demi_sums_add(&sums, by/beside->mass*(by/beside->mass));
    }
    s->runs[s->run + index] = sums;
}
/* Finds the lifts of all bodies, in at most `most` sweeps. */
static void demi_lifts_solve(dem_world *w, int most) {
    demi_solved o = {0, 0, 0, 0};
    do {
        demi_colours_all(w, demi_impulses_lift);
        demi_solved_tell(&w->solver, &o, demi_runs_sum(&w->solver));
    } while (o.worst > 0 && (++o.sweeps < DEMI_LIFTS ||
                             (o.sweeps < most && demi_solved_far(w, &o))));
}
/* True if no contact and no joint acts on body i. */
static int demi_mover_free(const dem_world *w, int i) {
    return !w->solver.colours[i] && !(w->joint_count && w->solver.joined[i] >= 0);
}
/* Sets forces and torques of a domain's bodies to those that produce the solved velocities in the
   coming step. Gravity is not part of them. Before, they are those of force fields, whose work, as
   that of impulses, is exact with the mean of the velocities before and after the step. The torque
   on a free body stays that of the fields, without round-off, so that the isolated bodies of >>near
   have a torque of exactly 0. */
static void demi_movers_force(dem_world *w, int d) {
    const demi_solver *s = &w->solver;
    const dem_real per = 1/s->dt;
    const int fields = w->desc.ledger && (w->desc.force || w->desc.body_force);
    double work = 0;
    int i, k;
    for (i = w->domains[d].begin; i < w->domains[d].end; i++) {
        const demi_mover *m = s->movers + i;
        const demi_lane b = demi_lane_move(w, i);
        dem_real *torque = w->bodies.torque + 4*i;
        if (!(m->inv > 0)) continue;
        for (k = 0; k < 3 && fields; k++)
            work += (double)b.f[k]*(double)(b.v[k] + m->v[k]) +
                (double)torque[k]*(double)(w->bodies.spin[4*i + k] + m->w[k]);
        for (k = 0; k < 3; k++) b.f[k] = ((m->v[k] - b.v[k])*per - b.g[k])/m->inv;
        if (w->bodies.shaped && w->bodies.shape[i]) {
            const dem_vec3 L = demi_body_turning(w, i, demi_at(m->w));
            if (demi_mover_free(w, i)) continue;
            demi_put(torque, demi_scale(demi_sub(L, demi_at(w->bodies.angular + 4*i)), per));
        } else
            for (k = 0; k < 3; k++)
                torque[k] = (m->w[k] - w->bodies.spin[4*i + k])*per/m->inv_inertia;
    }
    w->domains[d].energy[DEMI_E_FORCE] = work*(double)s->dt/2;
}
/* Notes a solved contact for events. old: it had an impulse before; energy: J, lost by its normal
   impulse, slip and rolling. */
static DEMI_APART void demi_impulse_note(dem_world *w, int d, const demi_meeting *m,
                                         const demi_spot *o, const demi_persistent *k, int old,
                                         dem_real force, const double *energy) {
    const int wall = k && k->b < 0;
    double all[DEMI_E_ROLL + 1] = {0};
    demi_noted_at *at;
    all[DEMI_E_DASHPOT] = energy[0];
    all[DEMI_E_SLIDE] = all[DEMI_E_SHEAR_WORK] = energy[1];
    all[DEMI_E_ROLL] = energy[2];
    at = demi_note(w, d, m->a, wall ? -1 - k->wall : m->b, old, 0, force, all);
    if (!at) return;
    at->normal = o->normal;
    at->arm = o->arm_a;
    at->shift = wall ? k->shift : demi_v(0, 0, 0);
}
/* Stores the results of a domain's constraints: contact history, forces on walls, energy losses.
   The work of an impulse is exact with the mean of the velocities before and after the step. */
static void demi_impulses_tell(dem_world *w, int d) {
    demi_solver *s = &w->solver;
    demi_domain *domain = &w->domains[d];
    const dem_real per = 1/s->dt;
    /* m/s: slips below this may be an error of the solver, or round-off */
    const dem_real slow = (dem_real)(10*w->booked.residual + (DEMI_SINGLE ? 1e-5 : 1e-10)*
                                     w->booked.speed_max);
    double *lost = domain->energy;              /* J, of the coming step */
    int i, e, counted = 0;
    domain->contacts = domain->persistent_walls = 0;
    for (i = 0; i < s->meeting_count[d]; i++) {
        const demi_meeting *m = s->meetings + s->meeting_first[d] + i;
        const demi_impulse *c = s->contacts + m->at;
        const demi_spot o = demi_meeting_place(w, d, m);
        demi_persistent *k = m->home < 0 ? w->persistent_next + w->persistent_first[d] + ~m->home
            : 0;
        dem_real *memory = k ? k->memory : w->near.memory +
            (size_t)d*DEMI_IMPULSE_REALS*o.stride + m->home;
        const dem_real push = c->push - s->beside[m->at].pull;
        const int old = o.memory[6*o.stride] > 0 || o.memory[7*o.stride] > 0;
        double part[3] = {0, 0, 0};             /* J, that it loses */
        int counts;
        const dem_vec3 p = demi_add(demi_scale(c->normal, push), c->slip);
        const dem_vec3 moment = s->twisted ? s->twists[m->at].moment : demi_v(0, 0, 0);
        const dem_vec3 after = demi_impulse_velocity(s, c, w->bodies.shaped > 0);
        const dem_vec3 u = demi_scale(demi_add(demi_impulse_before(w, c), after), DEM_R(0.5));
        const dem_real all[DEMI_IMPULSE_LOST] = {c->slip.x*per, c->slip.y*per, c->slip.z*per,
            moment.x*per, moment.y*per, moment.z*per, c->push*per, s->beside[m->at].pull*per,
            demi_dot(after, c->normal), s->beside[m->at].turns,
            demi_impulse_slides(c, after, slow, o.memory[DEMI_IMPULSE_SLIDES*o.stride]),
            c->normal.x, c->normal.y, c->normal.z};
        part[0] = -(double)demi_dot(demi_sub(p, c->slip), u);
        part[1] = -(double)demi_dot(c->slip, u);
        if (s->twisted) {
            const dem_vec3 wb = demi_add(demi_at(s->movers[m->b].w), m->b < w->bodies.count
                ? demi_at(w->bodies.spin + 4*m->b) : demi_at(s->movers[m->b].w));
            const dem_vec3 wa = demi_add(demi_at(s->movers[m->a].w),
                                         demi_at(w->bodies.spin + 4*m->a));
            part[2] = -(double)demi_dot(moment, demi_sub(wb, wa))/2;
        }
        for (e = 0; e < DEMI_IMPULSE_LOST; e++) memory[(size_t)e*o.stride] = all[e];
        for (; e < DEMI_IMPULSE_REALS; e++)
            memory[(size_t)e*o.stride] = (dem_real)part[e - DEMI_IMPULSE_LOST];
        lost[DEMI_E_DASHPOT] += part[0];
        lost[DEMI_E_SLIDE] += part[1];
        lost[DEMI_E_ROLL] += part[2];
        if (w->events.n.on) demi_impulse_note(w, d, m, &o, k, old, push*per, part);
        if (c->push > 0) {
            const int own = w->bodies.material[m->a] - 1;
            domain->met[DEMI_MIN(own, o.material)] |= UINT64_C(1) << DEMI_MAX(own, o.material);
        }
        if (!k || !k->corner) counted = 0;      /* of the points of polyhedra, one counts */
        counts = c->push > 0 && !counted;
        counted |= counts;
        if (k) k->force = demi_scale(p, -per);
        if (k && k->b < 0) {
            demi_wall_sum *sum = w->wall_sums + (size_t)d*(size_t)w->wall_count + k->wall;
            const dem_vec3 x = demi_add(demi_at(w->bodies.pos + 4*m->a), k->shift);
            const dem_vec3 at = demi_add(x, k->arm_a);
            demi_wall_sum_add(w, sum, k->wall, at, demi_scale(p, -per), demi_scale(moment, -per),
                              demi_at(s->movers[m->b].v));
            sum->contacts += counts;
            domain->persistent_walls += counts;
        } else domain->contacts += counts;
    }
}
/* Adds the contact forces to fixed bodies, for getters and output files. */
static void demi_impulses_fixed(dem_world *w) {
    const demi_solver *s = &w->solver;
    const dem_real per = 1/s->dt;
    int d, i, k;
    for (d = 0; d < w->domain_count && w->effects.fixed_count; d++)
        for (i = 0; i < s->meeting_count[d]; i++) {
            const demi_meeting *m = s->meetings + s->meeting_first[d] + i;
            const demi_impulse *c = s->contacts + m->at;
            const demi_spot o = demi_meeting_place(w, d, m);
            const dem_real push = c->push - s->beside[m->at].pull;
            const dem_vec3 p = demi_add(demi_scale(c->normal, push), c->slip);
            for (k = 0; k < 2; k++) {
                const int body = k ? m->b : m->a;
                const dem_real sign = k ? per : -per;
                dem_vec3 torque = demi_cross(k ? o.arm_b : o.arm_a, p);
                if (body >= w->bodies.count || s->movers[body].inv > 0) continue;
                if (s->twisted) torque = demi_add(torque, s->twists[m->at].moment);
                demi_force_add(w->bodies.force + 4*body, demi_scale(p, sign));
                demi_force_add(w->bodies.torque + 4*body, demi_scale(torque, sign));
            }
        }
}
/* Largest number of rounds of demi_impulses_tame. */
enum { DEMI_TAMINGS = 8 };
/* Mends the two kinds of contacts that may add energy, and returns their number. Newton's
   restitution and friction together may, if the slip reverses: halves the restitution of such an
   impact; with `last` sets it to 0, which loses energy for any shape. error: m/s, of the solve,
   which is no such gain. A contact that separates may,
   if an impact elsewhere on the body throws it back and a push stops it at a lower speed than it
   had: lets it approach at that speed, and bounce in the next step. */
static int demi_impulses_tame(dem_world *w, double error, int last) {
    demi_solver *s = &w->solver;
    int i, tamed = 0;
    for (i = 0; i < s->count; i++) {
        demi_impulse *c = s->contacts + i;
        dem_vec3 before, after, p;
        dem_real gain;
        if (s->beside[i].leaves > DEMI_MAX(c->bias, 0) && c->push > 0) {
            c->bias = s->beside[i].leaves;
            tamed++;
        }
        if (!s->beside[i].bounces || !(c->bias < 0) || !(c->push > 0)) continue;
        before = demi_impulse_before(w, c);
        after = demi_impulse_velocity(s, c, w->bodies.shaped > 0);
        p = demi_add(demi_scale(c->normal, c->push), c->slip);
        gain = demi_dot(p, demi_add(before, after));
        if (!(gain > ((DEMI_SINGLE ? DEM_R(1e-6) : DEM_R(1e-14))*-c->bias + (dem_real)error)*
                     c->push)) continue;
        c->bias = last ? 0 : c->bias/2;
        tamed++;
    }
    return tamed;
}
/* Returns the number of contacts at their friction limit. If many of them hold the same body, the
   error falls only as a power of the number of sweeps (docs/impulses.md). */
static int demi_solver_limited(const demi_solver *s) {
    int i, limited = 0;
    for (i = 0; i < s->count; i++) {
        const demi_impulse *c = &s->contacts[i];
        const dem_real most = c->mu*c->push*DEM_R(0.999999);
        limited += most > 0 && demi_dot(c->slip, c->slip) >= most*most;
    }
    return limited;
}
/* Solves the contact constraints and joints of the coming step, and applies the impulses as forces.
   Force fields must have been added before. */
static void demi_impulses(dem_world *w) {
    demi_solver *s = &w->solver;
    const int most = w->desc.sweeps ? w->desc.sweeps : 200;
    demi_solved solved = {0, 0, 0, 0};
    double farthest = 0;
    int i, d;
    s->dt = w->clock.dt;
    demi_domains_do(w, demi_movers_lay);
    demi_joints_lay(w);
    demi_domains_do(w, demi_impulses_meet);
    for (d = s->faced = s->seated = 0; d < w->domain_count; d++) {
        s->faced |= w->domains[d].faced && !demi_solvers[w->desc.solver].parts;
        s->seated |= w->domains[d].seated;
    }
    demi_impulses_colour(w);
    demi_domains_do(w, demi_impulses_lay);
    if (s->count || w->joint_count) {
        demi_colours_all(w, demi_impulses_warm);
        demi_joints_warm(w);
        solved = demi_solvers[w->desc.solver].solve(w, most);
        s->faced = s->seated = 0;               /* what follows begins with a small residual */
        for (i = 0; i < DEMI_TAMINGS &&
                    demi_impulses_tame(w, solved.worst, i == DEMI_TAMINGS - 1); i++)
            solved = demi_solvers[w->desc.solver].solve(w, most);
    }
    if (demi_solvers[w->desc.solver].parts && !demi_solved_far(w, &solved)) {
        demi_runs_all(w, demi_impulses_release);
        demi_colours_all(w, demi_vectors_apply);
    }
    w->booked.sweeps = solved.sweeps;
    w->booked.residual = solved.worst;
    w->booked.residual_rms = solved.rms;
    if (demi_solved_far(w, &solved)) {
        w->booked.unsolved++;
        s->limited = demi_solver_limited(s);
    }
    demi_domains_do(w, demi_movers_force);
    demi_domains_do(w, demi_impulses_tell);
    demi_impulses_fixed(w);
    demi_joints_tell(w);
    w->booked.due[0] = demi_sum_energy(w, DEMI_E_DASHPOT);
    w->booked.due[1] = demi_sum_energy(w, DEMI_E_SLIDE);
    w->booked.due[2] = demi_sum_energy(w, DEMI_E_ROLL);
    w->booked.due[3] = 0;
    w->booked.due[4] = demi_sum_energy(w, DEMI_E_FORCE);
    if (!w->stage.forces_valid) return;         /* forces only, no step */
    demi_lifts_solve(w, most);
    for (i = 0; i < w->bodies.count; i++) {
        const dem_vec3 way = demi_scale(demi_at(s->lifts + 4*i), s->dt);
        demi_force_add(w->bodies.last_pos + 4*i, way);
        farthest = DEMI_MAX(farthest, (double)demi_length(way));
    }
    demi_joints_bank(w);
    farthest += demi_joints_shift(w);
    w->margin.gone += farthest;
    w->margin.creep += 2*farthest;
}
/* Adds the work of walls, joints and motors in the coming step to the energies due. */
static void demi_impulses_due(dem_world *w) {
    int i;
    for (i = 0; i < w->joint_count; i++) {
        const demi_joint *j = &w->joints[i];
        w->booked.due[0] -= j->held;
        w->booked.due[3] += (double)j->state.power*(double)w->clock.dt;
    }
    for (i = 0; i < w->wall_count; i++)
        w->booked.due[3] += (double)w->walls[i].loads.power*(double)w->clock.dt;
}
/* Returns 1 if entry p of domain d's pruned neighbour list has an impulse or overlaps, and fills
   *out and *gap unless out is null: see demi_response_row. The normal of a constraint is that of
   its detection, half a step ahead of the present positions, because its force acts along it. */
static int demi_impulses_info(const dem_world *w, int d, int p, dem_contact_info *out,
                              dem_vec3 *gap) {
    const size_t stride = (size_t)w->near.stride, at = (size_t)d*stride + (size_t)p;
    const dem_real *memory = w->near.memory + (size_t)d*DEMI_IMPULSE_REALS*stride + p;
    const dem_real *x = w->bodies.pos + 4*w->near.a[at], *y = w->bodies.pos + 4*w->near.b[at];
    const dem_real *n = memory + DEMI_IMPULSE_NORMAL*stride;
    const dem_vec3 way = demi_near_way(w, at), normal = demi_v(n[0], n[stride], n[2*stride]);
    const dem_real l = demi_length(way), overlap = x[3] + y[3] - l;
    if (!(memory[6*stride] > 0) && !(memory[7*stride] > 0) && !(overlap > 0)) return 0;
    if (!out) return 1;
    out->normal = demi_dot(normal, normal) > 0 ? normal : demi_scale(way, 1/l);
    out->overlap = overlap;
    *gap = demi_scale(out->normal, l);
    out->force = demi_sub(demi_v(-memory[0], -memory[stride], -memory[2*stride]),
                          demi_scale(out->normal, memory[6*stride] - memory[7*stride]));
    return 1;
}
