/* ---------------------------------------------------------------------------------------------
   >>solvers
   Iterative solvers for the contact constraints of >>impulses (sequential impulses and its
   competitors). Velocities are in the solver bodies, and a solver applies every change of an
   impulse to both bodies. The residual of a contact is the step that would solve it alone, in m/s
   (the natural map in the metric of its inverse effective mass).
     Gauss-Seidel   contact after contact, each solved exactly in its own metric [JEA99]; for the
                    convex cone [TAS10] with the projection in that metric (again a cone, with
                    mu sqrt(gt/gn)). Between two sweeps the impulses also go on along a conjugate
                    direction [SIL10], as in the method of Fletcher and Reeves, with the change of
                    a sweep as the negative gradient; the next sweep projects onto the cones again.
                    The direction begins again where a change opposes it ([ODO15]).
     Jacobi         all contacts at once; each takes a part of its step that is smaller the more
                    contacts its bodies have [TON12]. For comparison: it needs six to twelve times
                    as many sweeps.
     APGD           Nesterov's accelerated gradients with restarts [MAZ15]; one product of
                    N = D' M^-1 D with impulses per sweep, since the product of a sum is the sum of
                    the products.
     Spectral       gradients with Barzilai-Borwein steps [BIR00] [HEY13], shortened to the exact
                    minimum along each direction.
   The last two minimise over the convex cone. Coulomb's law is that cone with mu |ut| added to the
   normal velocity (de Saxce); this term is updated every DEMI_SAXCE sweeps until it converges.
   >>add-solver: a row in demi_solvers and a constant in dem_solver.
   --------------------------------------------------------------------------------------------- */

/* Returns t, shortened to the length `most` if it is longer. */
DEM_INLINE dem_vec3 demi_impulse_cap(dem_vec3 t, dem_real most) {
    const dem_real l2 = demi_dot(t, t);
    return l2 > most*most ? demi_scale(t, most/DEMI_SQRT(l2)) : t;
}
/* Projects an impulse onto the friction cone. Coulomb: clips push to >= 0, then friction to its
   limit. Convex: takes the nearest point of the cone in the metric 1/per_n, 1/per_t. */
DEM_INLINE void demi_impulse_bound(const demi_impulse *c, dem_real *push, dem_vec3 *slip,
                                   int convex) {
    if (convex && c->mu > 0) {
        const dem_real a = DEMI_SQRT(c->per_n/c->per_t), mu = c->mu*a, size = a*demi_length(*slip);
        if (size > mu**push) {
            const dem_real p = mu*size <= -*push ? 0 : (*push + mu*size)/(1 + mu*mu);
            *push = DEMI_MAX(p, 0);
            *slip = demi_scale(*slip, mu**push/(size + DEMI_TINY));
        }
    } else {
        *push = DEMI_MAX(*push, 0);
        *slip = demi_impulse_cap(*slip, c->mu**push);
    }
}
/* Computes the impulse that solves a contact alone at relative velocity u. Returns the square of
   the change, (m/s)^2. */
DEM_INLINE dem_real demi_impulse_wanted(const demi_impulse *c, dem_vec3 u, dem_real *push,
                                        dem_vec3 *slip, int convex) {
    const dem_real un = demi_dot(u, c->normal);
    const dem_vec3 ut = demi_sub(u, demi_scale(c->normal, un));
    dem_real dn;
    dem_vec3 dt;
    *push = (c->push*c->gn - (un + c->bias))*c->per_n;
    *slip = demi_sub(c->slip, demi_scale(ut, c->per_t));
    demi_impulse_bound(c, push, slip, convex);
    dn = (*push - c->push)*c->gn;
    dt = demi_scale(demi_sub(*slip, c->slip), c->gt);
    return dn*dn + demi_dot(dt, dt);
}
/* Returns 1 if the contact slides: friction is at its limit, to round-off, and the slip of u (m/s)
   exceeds `slow`. The limit alone does not suffice: of several points that hold a body at rest one
   may be at its limit. Returns `was` if there is no normal impulse. */
DEM_INLINE dem_real demi_impulse_slides(const demi_impulse *c, dem_vec3 u, dem_real slow,
                                        dem_real was) {
    const dem_real most = c->mu*c->push*(1 - (DEMI_SINGLE ? DEM_R(1e-5) : DEM_R(1e-12)));
    const dem_vec3 slip = demi_sub(u, demi_scale(c->normal, demi_dot(u, c->normal)));
    if (!(c->push > 0)) return was;
    return demi_dot(c->slip, c->slip) >= most*most && demi_dot(slip, slip) > slow*slow ? DEM_R(1)
                                                                                        : DEM_R(0);
}
/* Returns the part s->step of a direction, by which an impulse goes on. The next direction is this
   plus `by`, the change of the last sweep. */
DEM_INLINE dem_vec3 demi_way_on(const demi_solver *s, dem_vec3 *way, dem_vec3 by) {
    const dem_vec3 on = s->sweep ? demi_scale(*way, s->step) : demi_v(0, 0, 0);
    *way = s->sweep ? demi_add(on, by) : on;
    return on;
}
/* Solves the rolling and spinning friction of one contact alone, after its impulse has gone on, and
   applies the change. */
DEM_INLINE void demi_twist_solve(const demi_solver *s, const demi_impulse *c, int shaped) {
    demi_twist *t = s->twists + (c - s->contacts);
    const demi_mover *a = s->movers + c->a, *b = s->movers + c->b;
    const dem_vec3 n = c->normal, w = demi_sub(demi_at(b->w), demi_at(a->w));
    const dem_vec3 had = demi_add(t->moment, demi_way_on(s, &t->way, t->by));
    const dem_real wn = demi_dot(w, n), mn = demi_dot(had, n), most = t->spin*c->push;
    const dem_vec3 wt = demi_sub(w, demi_scale(n, wn)), mt = demi_sub(had, demi_scale(n, mn));
    const dem_real spin = DEMI_MAX(-most, DEMI_MIN(most, mn - wn*t->per_spin));
    const dem_vec3 roll = demi_impulse_cap(demi_sub(mt, demi_scale(wt, t->per_roll)),
                                           t->roll*c->push);
    t->moment = demi_add(roll, demi_scale(n, spin));
    t->by = demi_sub(t->moment, had);
    demi_mover_push(s, c->a, demi_v(0, 0, 0), demi_scale(t->by, -1), shaped);
    demi_mover_push(s, c->b, demi_v(0, 0, 0), t->by, shaped);
}
/* Sums over one run of contacts: largest squared residual, (m/s)^2; sum of squared residuals; two
   more sums with a meaning for each solver. */
typedef struct demi_run_sums { dem_real worst, squares, first, second; } demi_run_sums;
DEM_INLINE void demi_sums_add(demi_run_sums *o, dem_real change2) {
    o->worst = DEMI_MAX(o->worst, change2);
    o->squares += change2;
}
/* Gives the contacts of run `index`, *begin to *end - 1. Runs divide the contacts from s->first to
   before s->last: those of one colour, or all. */
static void demi_run_bounds(const demi_solver *s, int index, int *begin, int *end) {
    *begin = s->first + index*DEMI_SWEEP_RUN;
    *end = DEMI_MIN(*begin + DEMI_SWEEP_RUN, s->last);
}
/* Calls a task for all contacts: colour after colour, the runs of a colour in parallel. */
static void demi_colours_all(dem_world *w, demi_task task) {
    demi_solver *s = &w->solver;
    int k;
    s->run = 0;
    for (k = 0; k < DEMI_COLOURS && s->begins[k] < s->count; k++) {
        const int n = s->begins[k + 1] - s->begins[k];
        const int runs = (n + DEMI_SWEEP_RUN - 1)/DEMI_SWEEP_RUN;
        s->first = s->begins[k];
        s->last = s->begins[k + 1];
        demi_parallel(w, k == DEMI_COLOURS - 1 ? 1 : w->threads.now, runs, 0, task);
        s->run += runs;
    }
}
/* Calls a task for all contacts in parallel, whatever their colour. The task must not change
   bodies. */
static void demi_runs_all(dem_world *w, demi_task task) {
    demi_solver *s = &w->solver;
    s->first = s->run = 0;
    s->last = s->count;
    demi_parallel(w, w->threads.now, (s->count + DEMI_SWEEP_RUN - 1)/DEMI_SWEEP_RUN, 0, task);
    s->run = (s->count + DEMI_SWEEP_RUN - 1)/DEMI_SWEEP_RUN;
}
/* Returns the sums over all runs of the last sweep. They are added in the order of runs, so the
   result does not depend on threads. */
static demi_run_sums demi_runs_sum(const demi_solver *s) {
    demi_run_sums all = {0, 0, 0, 0};
    int i;
    for (i = 0; i < s->run; i++) {
        all.worst = DEMI_MAX(all.worst, s->runs[i].worst);
        all.squares += s->runs[i].squares;
        all.first += s->runs[i].first;
        all.second += s->runs[i].second;
    }
    return all;
}
/* Warm start: applies the impulses of the last step to the bodies of a run. */
static void demi_impulses_warm(dem_world *w, int index) {
    demi_solver *s = &w->solver;
    const int shaped = w->bodies.shaped > 0;
    int i, end;
    for (demi_run_bounds(s, index, &i, &end); i < end; i++) {
        const demi_impulse *c = s->contacts + i;
        const dem_real push = c->push - s->beside[i].pull;
        demi_impulse_apply(s, c, demi_add(demi_scale(c->normal, push), c->slip), shaped);
        if (!s->twisted) continue;
        demi_mover_push(s, c->a, demi_v(0, 0, 0), demi_scale(s->twists[i].moment, -1), shaped);
        demi_mover_push(s, c->b, demi_v(0, 0, 0), s->twists[i].moment, shaped);
    }
}

/* Columns of s->vectors, one vector per contact: BY: change of the impulse. X, UX: impulse and
   relative velocity of the last iterate; Y, UY: of the point where the gradient is taken. BROUGHT:
   relative velocity that BY causes. BEGAN: impulse at the start. GIVEN: its x is the given bias. */
enum { DEMI_BY, DEMI_X, DEMI_UX, DEMI_Y, DEMI_UY, DEMI_BROUGHT, DEMI_BEGAN,
       DEMI_GIVEN };
DEM_INLINE dem_vec3 *demi_vector_at(const demi_solver *s, int column, int i) {
    return s->vectors + (size_t)column*(size_t)s->count + i;
}

/* --- Gauss-Seidel. Each contact has two vectors: the change of its impulse in the last sweep, and
   the direction in which the impulse goes on before the next. The velocity of a body goes on along
   the sum of these directions, which it has from its own changes: no contact is read for it. In the
   first sweep nothing goes on. --- */

/* Arrays of solver bodies: velocities before a sweep or, where joints follow it, what the sweep has
   changed; directions in which velocities go on. */
enum { DEMI_SWEPT = 1, DEMI_MOVER_WAY, DEMI_SEIDEL_COPIES };
static demi_mover *demi_mover_copy(const dem_world *w, int copy) {
    return w->solver.movers + (size_t)copy*(size_t)w->solver.mover_count;
}
/* Tells what a sweep has changed, before joints change it too. */
static void demi_movers_swept(dem_world *w, int d) {
    demi_mover *now = w->solver.movers, *swept = demi_mover_copy(w, DEMI_SWEPT);
    int i, k;
    for (i = w->domains[d].begin; i < w->domains[d].end; i++)
        for (k = 0; k < 3; k++) {
            swept[i].v[k] = now[i].v[k] - swept[i].v[k];
            swept[i].w[k] = now[i].w[k] - swept[i].w[k];
        }
}
/* Lets three components go on; told: `swept` is the change of the last sweep. */
DEM_INLINE void demi_velocity_on(const demi_solver *s, int told, dem_real *now, dem_real *swept,
                                 dem_real *way) {
    int k;
    for (k = 0; k < 3; k++) {
        const dem_real on = s->sweep ? s->step*way[k] : 0;
        way[k] = s->sweep ? on + (told ? swept[k] : now[k] - swept[k]) : 0;
        swept[k] = now[k] += on;
    }
}
/* Lets the bodies of work group d go on, before a sweep. */
static void demi_movers_on(dem_world *w, int d) {
    demi_mover *now = w->solver.movers, *swept = demi_mover_copy(w, DEMI_SWEPT);
    demi_mover *way = demi_mover_copy(w, DEMI_MOVER_WAY);
    const int told = w->solver.node_count > 0;
    int i;
    for (i = w->domains[d].begin; i < w->domains[d].end; i++) {
        demi_velocity_on(&w->solver, told, now[i].v, swept[i].v, way[i].v);
        demi_velocity_on(&w->solver, told, now[i].w, swept[i].w, way[i].w);
    }
}
/* Lets the impulses of contacts i to end - 1 go on. */
DEM_INLINE void demi_contacts_on(const demi_solver *s, int i, int end) {
    dem_vec3 *by = s->vectors + 2*(size_t)i;
    for (; i < end; i++, by += 2) {
        demi_impulse *c = s->contacts + i;
        demi_impulse_add(c, demi_way_on(s, by + 1, *by));
    }
}
/* Adds a change `by` of an impulse (along the normal: change) to the sums of a sweep, and stores
   it. first: its square; second: its product with the direction; both by the inverse effective
   masses. */
DEM_INLINE void demi_sums_way(demi_run_sums *o, const demi_impulse *c, dem_real change, dem_vec3 by,
                              dem_vec3 *vectors) {
    const dem_real more = change*(c->gn - c->gt);
    o->first += more*change + demi_dot(by, by)*c->gt;
    o->second += more*demi_dot(vectors[1], c->normal) + demi_dot(by, vectors[1])*c->gt;
    vectors[0] = by;
}
/* Bodies are prefetched this many contacts ahead, which saves a tenth of the time; so many contacts
   go on before they are solved. */
enum { DEMI_SOON = 8, DEMI_ON = 16 };
/* One Gauss-Seidel sweep over a run of contacts, for either cone and for spheres or any shapes. */
#define DEMI_SEIDEL(NAME, CONVEX, SHAPED) \
    static void NAME(dem_world *w, int index) { \
        demi_solver *s = &w->solver; \
        demi_run_sums sums = {0, 0, 0, 0}; \
        int i, end, on; \
        for (demi_run_bounds(s, index, &i, &end), on = i; i < end; i++) { \
            demi_impulse *c = s->contacts + i; \
            dem_real push; \
            dem_vec3 slip, by; \
            if (i == on) { \
                on = DEMI_MIN(on + DEMI_ON, end); \
                demi_contacts_on(s, i, on); \
            } \
            if (i + DEMI_SOON < end) { \
                DEMI_FETCH(s->movers + c[DEMI_SOON].a); \
                DEMI_FETCH(s->movers + c[DEMI_SOON].b); \
            } \
            demi_sums_add(&sums, demi_impulse_wanted(c, demi_impulse_velocity(s, c, SHAPED), \
                                                     &push, &slip, CONVEX)); \
            by = demi_add(demi_scale(c->normal, push - c->push), demi_sub(slip, c->slip)); \
            demi_sums_way(&sums, c, push - c->push, by, s->vectors + 2*(size_t)i); \
            c->push = push; \
            c->slip = slip; \
            demi_impulse_apply(s, c, by, SHAPED); \
            if (s->twisted) demi_twist_solve(s, c, SHAPED); \
        } \
        s->runs[s->run + index] = sums; \
    }
DEMI_SEIDEL(demi_seidel_spheres, 0, 0)
DEMI_SEIDEL(demi_seidel_spheres_convex, 1, 0)
DEMI_SEIDEL(demi_seidel_shapes, 0, 1)
DEMI_SEIDEL(demi_seidel_shapes_convex, 1, 1)
#undef DEMI_SEIDEL
/* Result of a solver: number of sweeps; largest and rms residual of the last sweep, rms residual of
   the first, m/s. */
typedef struct demi_solved { int sweeps; double worst, rms, first; } demi_solved;
/* Sets the residuals of a result from the sums of a sweep. */
static void demi_solved_tell(const demi_solver *s, demi_solved *o, demi_run_sums sums) {
    o->worst = sqrt((double)sums.worst);
    o->rms = sqrt((double)sums.squares/DEMI_MAX(s->count, 1));
    if (!o->sweeps) o->first = o->rms;
}
/* True if the solution is not converged. With desc.tolerance: the largest residual exceeds it.
   Otherwise: the rms residual exceeds what is allowed, or the largest 30 times that. */
static int demi_solved_far(const dem_world *w, const demi_solved *o) {
    const double enough = demi_solved_enough(w);
    if (w->desc.tolerance > 0) return o->worst > (double)w->desc.tolerance;
    return o->rms > enough || o->worst > 30*enough;
}
/* True if sweeps go on: if the solution is not converged and, where bodies lie on faces and there
   is no desc.tolerance, until the rms residual is half of the first and a tenth of what is allowed,
   or 1e-5 of that. An error acts on the next step like a change of velocity. If a step mends at
   least half of the error that it starts with, errors of successive steps do not add up, and towers
   do not sway. */
static int demi_solved_open(const dem_world *w, const demi_solved *o) {
    const double enough = demi_solved_enough(w), mends = DEMI_MIN(o->first/2, enough/10);
    const double tiny = DEMI_SINGLE ? 3e-4*enough + 1e-6*w->booked.speed_max : 1e-5*enough;
    return demi_solved_far(w, o) || (w->solver.faced && !(w->desc.tolerance > 0) &&
                                     o->rms > DEMI_MAX(mends, tiny));
}
/* Solves contacts and joints by Gauss-Seidel, in at most `most` sweeps; more if the energy guard of
   joints requires them. Solves towers before the first sweep and after it; then after each sweep,
   as long as that halves the residual, or else after four times as many sweeps as the last time. */
static demi_solved demi_solve_seidel(dem_world *w, int most) {
    const demi_task kinds[4] = {demi_seidel_spheres, demi_seidel_spheres_convex,
                                demi_seidel_shapes, demi_seidel_shapes_convex};
    const demi_task task = kinds[(w->desc.cone == DEM_CONE_CONVEX) + 2*(w->bodies.shaped > 0)];
    demi_solver *s = &w->solver;
    demi_solved o = {0, 0, 0, 0};
    dem_real last = 0;                          /* squared size of the change of the last sweep */
    double had = DBL_MAX;                       /* m/s, residual before towers were solved last */
    int tried = 0, wait = 1;                    /* sweeps before that, and from then to the next */
    int open, begun = 0;                        /* sweeps before the direction began */
    s->step = 0;
    if (s->seated) demi_towers_solve(w);
    do {
        demi_run_sums sums;
        dem_real joints;
        s->sweep = o.sweeps - begun;
        demi_domains_do(w, demi_movers_on);
        demi_colours_all(w, task);
        if (s->node_count) demi_domains_do(w, demi_movers_swept);
        sums = demi_runs_sum(s);
        joints = demi_joints_sweep(w);          /* once: a macro would evaluate it twice */
        sums.worst = DEMI_MAX(sums.worst, joints);
        demi_solved_tell(s, &o, sums);
        open = ++o.sweeps < most && demi_solved_open(w, &o);
        /* 0: the direction begins again; the sweep opposed it, or changes grew by a tenth */
        s->step = open && sums.second >= 0 && sums.first < DEM_R(1.1)*last
            ? DEMI_MIN(sums.first/last, 1) : 0;
        last = sums.first;
        if (!open || !s->seated) continue;
        if (o.sweeps == tried + 1) wait = o.rms < had/2 ? 1 : 4*wait;
        if (o.sweeps < tried + wait) continue;
        had = o.rms;
        tried = o.sweeps;
        if (demi_towers_solve(w)) begun = o.sweeps;
    } while (open || demi_joints_guard(w));
    return o;
}

/* --- Jacobi --- */

/* Computes the step of each contact at the same velocities, and takes the allowed part of it. */
static void demi_jacobi_look(dem_world *w, int index) {
    demi_solver *s = &w->solver;
    const int convex = w->desc.cone == DEM_CONE_CONVEX, shaped = w->bodies.shaped > 0;
    demi_run_sums sums = {0, 0, 0, 0};
    int i, end;
    for (demi_run_bounds(s, index, &i, &end); i < end; i++) {
        demi_impulse *c = s->contacts + i;
        const dem_real ia = s->movers[c->a].inv, ib = s->movers[c->b].inv;
        const dem_real ka = ia > 0 ? (dem_real)s->degrees[c->a] : 0;
        const dem_real kb = ib > 0 ? (dem_real)s->degrees[c->b] : 0;
        const dem_real part = DEMI_MIN(1, DEM_R(1.5)*(ia + ib)/(ka*ia + kb*ib));
        dem_real push;
        dem_vec3 slip;
        demi_sums_add(&sums, demi_impulse_wanted(c, demi_impulse_velocity(s, c, shaped), &push,
                                                 &slip, convex));
        push = part*(push - c->push);
        slip = demi_scale(demi_sub(slip, c->slip), part);
        s->vectors[i] = demi_add(demi_scale(c->normal, push), slip);
        c->push += push;
        c->slip = demi_add(c->slip, slip);
    }
    s->runs[index] = sums;
}
/* Applies the impulses in s->vectors to the bodies of a run. */
static void demi_vectors_apply(dem_world *w, int index) {
    const demi_solver *s = &w->solver;
    const int shaped = w->bodies.shaped > 0;
    int i, end;
    for (demi_run_bounds(s, index, &i, &end); i < end; i++)
        demi_impulse_apply(s, s->contacts + i, s->vectors[i], shaped);
}
/* Solves by Jacobi's method in at most `most` sweeps. */
static demi_solved demi_solve_jacobi(dem_world *w, int most) {
    demi_solver *s = &w->solver;
    demi_solved o = {0, 0, 0, 0};
    int i;
    memset(s->degrees, 0, (size_t)w->bodies.count*sizeof *s->degrees);
    for (i = 0; i < s->count; i++) {
        s->degrees[s->contacts[i].a]++;
        if (s->contacts[i].b < w->bodies.count) s->degrees[s->contacts[i].b]++;
    }
    do {
        demi_run_sums sums;
        demi_runs_all(w, demi_jacobi_look);
        sums = demi_runs_sum(s);
        demi_solved_tell(s, &o, sums);
        demi_colours_all(w, demi_vectors_apply);
    } while (++o.sweeps < most && demi_solved_open(w, &o));
    return o;
}

/* Lets go of contacts that do not push, but of which a solver that takes parts of steps has left a
   remainder of an impulse. */
static void demi_impulses_release(dem_world *w, int index) {
    demi_solver *s = &w->solver;
    const int convex = w->desc.cone == DEM_CONE_CONVEX, shaped = w->bodies.shaped > 0;
    int i, end;
    for (demi_run_bounds(s, index, &i, &end); i < end; i++) {
        demi_impulse *c = s->contacts + i;
        dem_real push;
        dem_vec3 slip;
        s->vectors[i] = demi_v(0, 0, 0);
        demi_impulse_wanted(c, demi_impulse_velocity(s, c, shaped), &push, &slip, convex);
        if (push > 0 || !(c->push > 0)) continue;
        s->vectors[i] = demi_scale(demi_add(demi_scale(c->normal, c->push), c->slip), -1);
        c->push = 0;
        c->slip = demi_v(0, 0, 0);
    }
}

/* --- gradients --- */

DEM_INLINE void demi_impulse_put(demi_impulse *c, dem_vec3 p) {
    c->push = demi_dot(p, c->normal);
    c->slip = demi_sub(p, demi_scale(c->normal, c->push));
}
/* Returns the gradient, m/s, at impulse p and relative velocity u. */
DEM_INLINE dem_vec3 demi_gradient(const demi_impulse *c, dem_vec3 u, dem_vec3 p) {
    const dem_real soft = 1/c->per_n - c->gn;
    return demi_add(u, demi_scale(c->normal, c->bias + soft*demi_dot(p, c->normal)));
}
/* Returns the squared norm of an impulse in the metric 1/per_n, 1/per_t. */
DEM_INLINE dem_real demi_impulse_size2(const demi_impulse *c, dem_vec3 p) {
    const dem_real n = demi_dot(p, c->normal);
    return n*n/c->per_n + (demi_dot(p, p) - n*n)/c->per_t;
}
/* Sets BY to a step from Y against the gradient, of length s->step, projected onto the cone. Sum
   `first`: the product of gradient and BY. */
static void demi_gradient_step(dem_world *w, int index) {
    demi_solver *s = &w->solver;
    demi_run_sums sums = {0, 0, 0, 0};
    int i, end;
    for (demi_run_bounds(s, index, &i, &end); i < end; i++) {
        const demi_impulse *c = s->contacts + i;
        const dem_vec3 p = *demi_vector_at(s, DEMI_Y, i);
        const dem_vec3 g = demi_gradient(c, *demi_vector_at(s, DEMI_UY, i), p);
        const dem_real gn = demi_dot(g, c->normal), pn = demi_dot(p, c->normal);
        const dem_vec3 gt = demi_sub(g, demi_scale(c->normal, gn));
        dem_vec3 slip = demi_sub(demi_sub(p, demi_scale(c->normal, pn)),
                                 demi_scale(gt, s->step*c->per_t));
        dem_real push = pn - s->step*gn*c->per_n;
        demi_impulse_bound(c, &push, &slip, 1);
        *demi_vector_at(s, DEMI_BY, i) = demi_sub(demi_add(demi_scale(c->normal, push), slip), p);
        sums.first += demi_dot(g, *demi_vector_at(s, DEMI_BY, i));
    }
    s->runs[index] = sums;
}
/* Sets BROUGHT to the velocity that BY has given to the bodies. Sums: first: BY.N BY; second: the
   squared norm of N BY; squares: that of BY. */
static void demi_gradient_brought(dem_world *w, int index) {
    demi_solver *s = &w->solver;
    const int shaped = w->bodies.shaped > 0;
    demi_run_sums sums = {0, 0, 0, 0};
    int i, end;
    for (demi_run_bounds(s, index, &i, &end); i < end; i++) {
        const demi_impulse *c = s->contacts + i;
        const dem_vec3 by = *demi_vector_at(s, DEMI_BY, i), u = demi_impulse_velocity(s, c, shaped);
        const dem_real soft = 1/c->per_n - c->gn;
        const dem_vec3 all = demi_add(u, demi_scale(c->normal, soft*demi_dot(by, c->normal)));
        const dem_real n = demi_dot(all, c->normal);
        *demi_vector_at(s, DEMI_BROUGHT, i) = u;
        sums.first += demi_dot(by, all);
        sums.second += n*n*c->per_n + (demi_dot(all, all) - n*n)*c->per_t;
        sums.squares += demi_impulse_size2(c, by);
    }
    s->runs[index] = sums;
}
/* Computes the product of N and BY, into BROUGHT. Returns the sums of demi_gradient_brought. */
static demi_run_sums demi_gradient_product(dem_world *w) {
    demi_solver *s = &w->solver;
    const int movers = w->bodies.count + w->persistent_first[DEMI_DOMAINS];
    int i, k;
    for (i = 0; i < movers; i++)
        for (k = 0; k < 3; k++) s->movers[i].v[k] = s->movers[i].w[k] = 0;
    demi_colours_all(w, demi_vectors_apply);
    demi_runs_all(w, demi_gradient_brought);
    return demi_runs_sum(s);
}
/* Moves Y by s->step times BY, and sums the residual there. Sum `first`: the product of the
   gradient before the move and the new Y - X. The residual of Coulomb's law uses the given bias. */
static void demi_gradient_go(dem_world *w, int index) {
    demi_solver *s = &w->solver;
    const int convex = w->desc.cone == DEM_CONE_CONVEX;
    demi_run_sums sums = {0, 0, 0, 0};
    int i, end;
    for (demi_run_bounds(s, index, &i, &end); i < end; i++) {
        demi_impulse *c = s->contacts + i;
        dem_vec3 *y = demi_vector_at(s, DEMI_Y, i), *uy = demi_vector_at(s, DEMI_UY, i);
        const dem_vec3 g = demi_gradient(c, *uy, *y);
        const dem_real bias = c->bias;
        dem_real push;
        dem_vec3 slip;
        *y = demi_add(*y, demi_scale(*demi_vector_at(s, DEMI_BY, i), s->step));
        *uy = demi_add(*uy, demi_scale(*demi_vector_at(s, DEMI_BROUGHT, i), s->step));
        demi_impulse_put(c, *y);
        if (!convex) c->bias = demi_vector_at(s, DEMI_GIVEN, i)->x;
        demi_sums_add(&sums, demi_impulse_wanted(c, *uy, &push, &slip, convex));
        c->bias = bias;
        sums.first += demi_dot(g, demi_sub(*y, *demi_vector_at(s, DEMI_X, i)));
    }
    s->runs[index] = sums;
}
/* Extrapolates: X becomes Y, and Y moves on by s->step times its distance from the old X. */
static void demi_gradient_on(dem_world *w, int index) {
    demi_solver *s = &w->solver;
    int i, end;
    for (demi_run_bounds(s, index, &i, &end); i < end; i++) {
        const dem_vec3 y = *demi_vector_at(s, DEMI_Y, i), uy = *demi_vector_at(s, DEMI_UY, i);
        const dem_vec3 way = demi_sub(y, *demi_vector_at(s, DEMI_X, i));
        const dem_vec3 gone = demi_sub(uy, *demi_vector_at(s, DEMI_UX, i));
        *demi_vector_at(s, DEMI_X, i) = y;
        *demi_vector_at(s, DEMI_UX, i) = uy;
        *demi_vector_at(s, DEMI_Y, i) = demi_add(y, demi_scale(way, s->step));
        *demi_vector_at(s, DEMI_UY, i) = demi_add(uy, demi_scale(gone, s->step));
    }
}
/* Coulomb's law: sets the bias to the given one plus mu |ut| of the present velocities. */
static void demi_gradient_saxce(dem_world *w, int index) {
    demi_solver *s = &w->solver;
    int i, end;
    for (demi_run_bounds(s, index, &i, &end); i < end; i++) {
        demi_impulse *c = s->contacts + i;
        const dem_vec3 u = *demi_vector_at(s, DEMI_UY, i);
        const dem_vec3 ut = demi_sub(u, demi_scale(c->normal, demi_dot(u, c->normal)));
        c->bias = demi_vector_at(s, DEMI_GIVEN, i)->x + c->mu*demi_length(ut);
    }
}
/* Sets the starting point of a gradient method. */
static void demi_gradient_begin(dem_world *w, int index) {
    demi_solver *s = &w->solver;
    const int shaped = w->bodies.shaped > 0;
    int i, end;
    for (demi_run_bounds(s, index, &i, &end); i < end; i++) {
        const demi_impulse *c = s->contacts + i;
        const dem_vec3 p = demi_impulse_vector(c), u = demi_impulse_velocity(s, c, shaped);
        *demi_vector_at(s, DEMI_X, i) = *demi_vector_at(s, DEMI_Y, i) = p;
        *demi_vector_at(s, DEMI_UX, i) = *demi_vector_at(s, DEMI_UY, i) = u;
        *demi_vector_at(s, DEMI_BEGAN, i) = p;
        *demi_vector_at(s, DEMI_GIVEN, i) = demi_v(c->bias, 0, 0);
    }
}
/* One step of Nesterov's method. theta (momentum) and L (an estimate of the largest eigenvalue of
   N) persist between steps. Returns the sums of the residual. */
static demi_run_sums demi_step_apgd(dem_world *w, double *theta, double *L) {
    demi_solver *s = &w->solver;
    demi_run_sums sums, gone;
    double next, beta;
    int tries;
    for (tries = 0; tries < 60; tries++) {      /* L doubles: 60 times is more than any N needs */
        s->step = (dem_real)(1/ *L);
        demi_runs_all(w, demi_gradient_step);
        gone = demi_gradient_product(w);
        if (!((double)gone.first > *L*(double)gone.squares)) break;
        *L *= 2;
    }
    s->step = 1;
    demi_runs_all(w, demi_gradient_go);
    sums = demi_runs_sum(s);
    next = (-*theta**theta + *theta*sqrt(*theta**theta + 4))/2;
    beta = *theta*(1 - *theta)/(*theta**theta + next);
    *theta = sums.first > 0 ? 1 : next;         /* uphill: restart */
    s->step = (dem_real)(sums.first > 0 ? 0 : beta);
    demi_runs_all(w, demi_gradient_on);
    *L *= 0.9;
    return sums;
}
/* One step of the method of Barzilai and Borwein. Its length persists between steps; `odd`
   alternates between their two formulas. Returns the sums of the residual. */
static demi_run_sums demi_step_spectral(dem_world *w, double *length, double *odd) {
    demi_solver *s = &w->solver;
    demi_run_sums gone;
    double down;
    s->step = (dem_real)*length;
    demi_runs_all(w, demi_gradient_step);
    down = (double)demi_runs_sum(s).first;
    gone = demi_gradient_product(w);
    s->step = gone.first > 0 ? (dem_real)DEMI_MIN(1, -down/(double)gone.first) : 1;
    if (!(s->step > 0)) s->step = 1;
    demi_runs_all(w, demi_gradient_go);
    *odd = 1 - *odd;
    *length = !(gone.first > 0) ? 1 : *odd > 0 ? (double)gone.squares/(double)gone.first
        : (double)gone.first/(double)gone.second;
    *length = DEMI_MAX(1e-6, DEMI_MIN(*length, 1e6));
    return demi_runs_sum(s);
}
enum { DEMI_SAXCE = 25 };                       /* steps between two calls of demi_gradient_saxce */
/* Runs a gradient method, of which `step` is one step with two numbers that persist. The solver
   bodies are work space meanwhile; at the end they get the total change of the impulses. */
static demi_solved demi_solve_gradient(dem_world *w, int most,
                                       demi_run_sums (*step)(dem_world *w, double *a, double *b)) {
    demi_solver *s = &w->solver;
    const size_t movers = (size_t)(w->bodies.count + w->persistent_first[DEMI_DOMAINS]);
    const int coulomb = w->desc.cone == DEM_CONE_COULOMB;
    demi_solved o = {0, 0, 0, 0};
    double a = 1, b = 1;
    int i;
    memcpy(s->movers + movers, s->movers, movers*sizeof *s->movers);
    demi_runs_all(w, demi_gradient_begin);
    do {
        demi_run_sums sums;
        if (coulomb && o.sweeps % DEMI_SAXCE == 0) {
            demi_runs_all(w, demi_gradient_saxce);
            a = b = 1;
        }
        sums = step(w, &a, &b);
        demi_solved_tell(s, &o, sums);
    } while (++o.sweeps < most && demi_solved_open(w, &o));
    memcpy(s->movers, s->movers + movers, movers*sizeof *s->movers);
    for (i = 0; i < s->count; i++) {
        s->contacts[i].bias = demi_vector_at(s, DEMI_GIVEN, i)->x;
        *demi_vector_at(s, DEMI_BY, i) = demi_sub(demi_impulse_vector(s->contacts + i),
                                               *demi_vector_at(s, DEMI_BEGAN, i));
    }
    demi_colours_all(w, demi_vectors_apply);
    return o;
}
static demi_solved demi_solve_apgd(dem_world *w, int most) {
    return demi_solve_gradient(w, most, demi_step_apgd);
}
static demi_solved demi_solve_spectral(dem_world *w, int most) {
    return demi_solve_gradient(w, most, demi_step_spectral);
}

/* A solver. vectors: number of columns that it needs; copies: number of arrays of solver bodies;
   moments: 1 if it supports rolling and spinning friction; joints: 1 if it supports joints; parts:
   1 if it takes parts of steps, so that contacts that do not push may keep a remainder of an
   impulse; most: largest number of sweeps. */
typedef struct demi_solver_row {
    const char *name;
    int vectors, copies, moments, joints, parts;
    demi_solved (*solve)(dem_world *w, int most);
} demi_solver_row;
static const demi_solver_row demi_solvers[] = {
    {"Gauss-Seidel", 2, DEMI_SEIDEL_COPIES, 1, 1, 0, demi_solve_seidel},
    {"Jacobi", 1, 1, 0, 0, 1, demi_solve_jacobi},
    {"APGD", DEMI_GIVEN + 1, 2, 0, 0, 1, demi_solve_apgd},
    {"spectral gradients", DEMI_GIVEN + 1, 2, 0, 0, 1, demi_solve_spectral}
};
enum { DEMI_SOLVERS = sizeof demi_solvers/sizeof *demi_solvers };
