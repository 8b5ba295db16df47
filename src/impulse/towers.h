/* ---------------------------------------------------------------------------------------------
   >>towers
   Direct solution of the contact constraints of towers, which are stacks of polyhedra and
   clusters. A sweep of >>solvers carries a change of velocity a few bodies further, and a tower
   bends so easily that the number of sweeps it needs grows with the square of its height.
   A seat joins two bodies, or a body and a wall, that touch at three or more points; these push,
   stick and are not on one line. Its two bodies move together, so along a tree of seats the
   impulses follow from momenta alone (recursive Newton-Euler algorithm [FEA08]). From walls and
   fixed bodies upwards, each body gets the velocity at which the points of its seat are at rest
   (least squares). From the leaves downwards, each seat gets the momentum that the bodies beyond
   it need, and divides it among its points like a rigid face. If that would make a point pull or
   slide, the whole tree takes only the largest part of the change at which no point does.
   Sweeps reduce an energy. The whole change takes the impulses of the seats to its minimum, a part
   goes part of the way: neither increases it. Bodies that no seats connect to a wall or a fixed
   body are in no tree; planar worlds have none.
   Owns seats and trees of w->solver; changes impulses and solver bodies.
   Tests: tests/impulse/test_towers.c, tests/hard/hard_rest.c.
   --------------------------------------------------------------------------------------------- */

/* A seat of two bodies, or of a body and a wall. */
typedef struct demi_seat {
    int32_t ends[2], next[2];      /* a and b; -1: a wall or prescribed motion. Next seat of each */
    int32_t first, last;           /* its constraints: entries of demi_solver.meetings */
    int32_t points;                /* number of points that hold */
    dem_vec3 arm[2];               /* m, from the centres of a and b to the mean of the points */
    dem_real per[6];               /* 1/m2, inverse of their second moment: xx yy zz xy xz yz */
    dem_vec3 push, turn;           /* an impulse on b, see demi_seat_share */
} demi_seat;
/* A body with seats. */
typedef struct demi_tree_body {
    int32_t seats, root;           /* first seat; root of its tree, which rests on a wall or a fixed
                                      body; -1: none */
    int32_t seat, end, level;      /* seat towards the root; which end of it the body is; number of
                                      seats down to the wall or fixed body */
    dem_vec3 v, w;                 /* m/s, rad/s: change of velocity */
    dem_vec3 push, turn;           /* N s, N m s about the centre: momentum that this body and the
                                      bodies beyond it need */
    dem_real part;                 /* of a root: part of the step that its tree takes */
} demi_tree_body;

/* Trees with more levels than this are tall: residuals must be small (demi_solved_open). */
enum { DEMI_TALL = 3 };
/* True if a point holds: it is rigid, pushes and sticks. */
static int demi_point_holds(const demi_impulse *c) {
    const dem_real most = c->mu*c->push*DEM_R(0.999);
    return c->push > 0 && c->gn*c->per_n > DEM_R(0.999999) &&
        demi_dot(c->slip, c->slip) < most*most;
}
/* Returns the largest part, up to 1, of a change `by` that leaves an impulse in its cone. */
static dem_real demi_point_part(const demi_impulse *c, dem_vec3 by) {
    const dem_real push = demi_dot(by, c->normal), mu2 = c->mu*c->mu;
    const dem_vec3 slip = demi_sub(by, demi_scale(c->normal, push));
    /* |slip + x by| = mu (push + x by): a x2 + 2 b x + q = 0, where q < 0 */
    const dem_real a = demi_dot(slip, slip) - mu2*push*push;
    const dem_real b = demi_dot(slip, c->slip) - mu2*push*c->push;
    const dem_real q = demi_dot(c->slip, c->slip) - mu2*c->push*c->push, root = b*b - a*q;
    const dem_real most = push < 0 ? DEMI_MIN(1, -c->push/push) : 1;
    const dem_real sum = root > 0 ? b + DEMI_SQRT(root) : 0;
    return sum > 0 ? DEMI_MIN(most, -q/sum) : most;
}
/* Adds a point at r to the tensor of second moments, the sum of r2 - r r'. */
static void demi_moment_add(dem_real *t, dem_vec3 r) {
    t[0] += r.y*r.y + r.z*r.z;
    t[1] += r.x*r.x + r.z*r.z;
    t[2] += r.x*r.x + r.y*r.y;
    t[3] -= r.x*r.y;
    t[4] -= r.x*r.z;
    t[5] -= r.y*r.z;
}
/* Inverts such a tensor in place. Returns 0 if the points are nearly on one line. */
static int demi_moment_invert(dem_real *t) {
    const dem_real xx = t[1]*t[2] - t[5]*t[5], xy = t[4]*t[5] - t[3]*t[2];
    const dem_real xz = t[3]*t[5] - t[4]*t[1], trace = t[0] + t[1] + t[2];
    const dem_real yy = t[0]*t[2] - t[4]*t[4], zz = t[0]*t[1] - t[3]*t[3];
    const dem_real yz = t[3]*t[4] - t[0]*t[5], det = t[0]*xx + t[3]*xy + t[4]*xz;
    if (!(det > DEM_R(1e-4)*trace*trace*trace)) return 0;
    t[0] = xx/det; t[1] = yy/det; t[2] = zz/det;
    t[3] = xy/det; t[4] = xz/det; t[5] = yz/det;
    return 1;
}

/* --- seats --- */

/* Returns the vector from the mean point of a seat to the point of contact `at`, m. */
static dem_vec3 demi_seat_to(const demi_solver *s, const demi_seat *seat, int at) {
    return demi_sub(s->arms[2*at], seat->arm[0]);
}
/* Divides an impulse p, N s, with the moment l about the mean point, N m s, among the points of a
   seat: those shares with the least sum of squares. */
static void demi_seat_divide(demi_seat *seat, dem_vec3 p, dem_vec3 l) {
    seat->push = demi_scale(p, 1/(dem_real)seat->points);
    seat->turn = demi_tensor_times(seat->per, l);
}
/* Returns the share of a point, N s. */
static dem_vec3 demi_seat_share(const demi_solver *s, const demi_seat *seat, int at) {
    return demi_add(seat->push, demi_cross(seat->turn, demi_seat_to(s, seat, at)));
}
/* Divides the present impulse of a seat among its points again, half of the way that their cones
   allow. That leaves sum and moment, and so all velocities, as they are. Otherwise points whose
   differences change no velocity would drift to the limits of their cones. */
static void demi_seat_even(const dem_world *w, demi_seat *seat) {
    const demi_solver *s = &w->solver;
    const dem_real slack = (dem_real)(3e-4*demi_solved_enough(w));
    dem_vec3 p = demi_v(0, 0, 0), l = p;
    dem_real part = 1;
    int i;
    for (i = seat->first; i < seat->last; i++) {
        const int at = s->meetings[i].at;
        const demi_impulse *c = s->contacts + at;
        if (!s->beside[at].holds) continue;
        if (DEMI_ABS(c->bias) > slack) return;  /* it would not leave the energy as it is */
        p = demi_add(p, demi_impulse_vector(c));
        l = demi_add(l, demi_cross(demi_seat_to(s, seat, at), demi_impulse_vector(c)));
    }
    demi_seat_divide(seat, p, l);
    for (i = seat->first; i < seat->last; i++) {
        const int at = s->meetings[i].at;
        const demi_impulse *c = s->contacts + at;
        if (s->beside[at].holds)
            part = DEMI_MIN(part, demi_point_part(c, demi_sub(demi_seat_share(s, seat, at),
                                                              demi_impulse_vector(c))));
    }
    for (i = seat->first; i < seat->last; i++) {
        const int at = s->meetings[i].at;
        demi_impulse *c = s->contacts + at;
        if (s->beside[at].holds)
            demi_impulse_add(c, demi_scale(demi_sub(demi_seat_share(s, seat, at),
                                                    demi_impulse_vector(c)), part/2));
    }
}
/* Sets up a seat of the constraints `first` to `last` - 1. Returns 0 if it does not hold. */
static int demi_seat_lay(const dem_world *w, demi_seat *seat, int first, int last) {
    const demi_solver *s = &w->solver;
    const demi_meeting *m = s->meetings;
    int i, k;
    memset(seat, 0, sizeof *seat);
    seat->first = first;
    seat->last = last;
    for (i = first; i < last; i++) {
        s->beside[m[i].at].holds = demi_point_holds(s->contacts + m[i].at);
        if (!s->beside[m[i].at].holds) continue;
        seat->points++;
        for (k = 0; k < 2; k++)
            seat->arm[k] = demi_add(seat->arm[k], s->arms[2*m[i].at + k]);
    }
    if (seat->points < 3) return 0;
    for (k = 0; k < 2; k++) seat->arm[k] = demi_scale(seat->arm[k], 1/(dem_real)seat->points);
    for (i = first; i < last; i++)
        if (s->beside[m[i].at].holds)
            demi_moment_add(seat->per, demi_seat_to(s, seat, m[i].at));
    seat->ends[0] = s->movers[m[first].a].inv > 0 ? m[first].a : -1;
    seat->ends[1] = m[first].b < w->bodies.count && s->movers[m[first].b].inv > 0 ? m[first].b : -1;
    return demi_moment_invert(seat->per);
}
/* Finds all seats, and links those of each body. */
static void demi_seats_find(dem_world *w) {
    demi_solver *s = &w->solver;
    int d, i, next, e;
    s->seat_count = 0;
    for (i = 0; i < w->bodies.count; i++) s->trees[i].seats = s->trees[i].root = -1;
    for (d = 0; d < w->domain_count; d++) {
        const int end = s->meeting_first[d] + s->meeting_count[d];
        for (i = s->meeting_first[d]; i < end; i = next) {
            demi_seat *seat = s->seats + s->seat_count;
            for (next = i + 1; next < end && s->meetings[next].same; next++) continue;
            if (next - i < 3 || !demi_seat_lay(w, seat, i, next)) continue;
            demi_seat_even(w, seat);
            for (e = 0; e < 2; e++) {
                if (seat->ends[e] < 0) continue;
                seat->next[e] = s->trees[seat->ends[e]].seats;
                s->trees[seat->ends[e]].seats = s->seat_count;
            }
            s->seat_count++;
        }
    }
}

/* --- trees --- */

/* Adds the body at one end of a seat to the tree of `root`, or (-1) as a root, if it has none. */
static void demi_tree_join(demi_solver *s, int seat, int end, int root) {
    const int body = s->seats[seat].ends[end];
    demi_tree_body *t = s->trees + body;
    if (body < 0 || t->root >= 0) return;
    t->seat = seat;
    t->end = end;
    t->root = root < 0 ? body : root;
    t->level = root < 0 ? 1 : s->trees[s->seats[seat].ends[!end]].level + 1;
    t->part = 1;
    s->treed[s->treed_count++] = body;
}
/* Orders the bodies of all trees by their distance from the root. */
static void demi_trees_order(demi_solver *s) {
    int i, k, e;
    s->treed_count = 0;
    for (i = 0; i < s->seat_count; i++)
        for (e = 0; e < 2; e++)
            if (s->seats[i].ends[!e] < 0) demi_tree_join(s, i, e, -1);
    for (k = 0; k < s->treed_count; k++)
        for (i = s->trees[s->treed[k]].seats; i >= 0; i = s->seats[i].next[e]) {
            e = s->seats[i].ends[0] != s->treed[k];
            demi_tree_join(s, i, !e, s->trees[s->treed[k]].root);
        }
}
/* Computes the change of velocity at which the points of a body's seat are at rest, given that of
   the body at its other end; and the momentum that it takes. */
static void demi_tree_rise(const dem_world *w, int body) {
    const demi_solver *s = &w->solver;
    demi_tree_body *t = s->trees + body;
    const demi_seat *seat = s->seats + t->seat;
    const int from = seat->ends[!t->end];
    const dem_real sign = t->end ? 1 : -1;
    dem_vec3 v = demi_v(0, 0, 0), spin = v;
    int i;
    for (i = seat->first; i < seat->last; i++) {
        const int at = s->meetings[i].at;
        const demi_impulse *c = s->contacts + at;
        dem_vec3 u;
        if (!s->beside[at].holds) continue;
        u = demi_add(demi_impulse_velocity(s, c, 1), demi_scale(c->normal, c->bias));
        v = demi_sub(v, u);
        spin = demi_sub(spin, demi_cross(demi_seat_to(s, seat, at), u));
    }
    v = demi_scale(v, sign/(dem_real)seat->points);
    t->w = demi_scale(demi_tensor_times(seat->per, spin), sign);
    if (from >= 0) {
        const demi_tree_body *f = s->trees + from;
        t->w = demi_add(t->w, f->w);
        v = demi_add(v, demi_add(f->v, demi_cross(f->w, seat->arm[!t->end])));
    }
    t->v = demi_sub(v, demi_cross(t->w, seat->arm[t->end]));
    t->push = demi_scale(t->v, 1/s->movers[body].inv);
    t->turn = demi_body_turning(w, body, t->w);
}
/* Gives the seat of a body the momentum that this body and all beyond it need, and adds it to the
   body at the other end. */
static void demi_tree_load(demi_solver *s, int body) {
    const demi_tree_body *t = s->trees + body;
    demi_seat *seat = s->seats + t->seat;
    const int from = seat->ends[!t->end];
    const dem_vec3 turn = demi_sub(t->turn, demi_cross(seat->arm[t->end], t->push));
    const dem_real sign = t->end ? 1 : -1;
    demi_seat_divide(seat, demi_scale(t->push, sign), demi_scale(turn, sign));
    if (from < 0) return;
    s->trees[from].push = demi_add(s->trees[from].push, t->push);
    s->trees[from].turn = demi_add(s->trees[from].turn,
                                   demi_add(turn, demi_cross(seat->arm[!t->end], t->push)));
}
/* Limits the step of a body's tree to what the points of its seat allow. */
static void demi_tree_limit(demi_solver *s, int body) {
    const demi_seat *seat = s->seats + s->trees[body].seat;
    dem_real *part = &s->trees[s->trees[body].root].part;
    int i;
    for (i = seat->first; i < seat->last; i++) {
        const int at = s->meetings[i].at;
        const dem_vec3 by = demi_seat_share(s, seat, at);
        if (s->beside[at].holds)
            *part = DEMI_MIN(*part, demi_point_part(s->contacts + at, by));
    }
}
/* Takes the step of a body and its seat. */
static void demi_tree_go(demi_solver *s, int body) {
    const demi_tree_body *t = s->trees + body;
    const demi_seat *seat = s->seats + t->seat;
    const dem_real part = s->trees[t->root].part;
    demi_mover *m = s->movers + body;
    int i;
    for (i = seat->first; i < seat->last; i++) {
        const int at = s->meetings[i].at;
        if (s->beside[at].holds)
            demi_impulse_add(s->contacts + at, demi_scale(demi_seat_share(s, seat, at), part));
    }
    demi_put(m->v, demi_add(demi_at(m->v), demi_scale(t->v, part)));
    demi_put(m->w, demi_add(demi_at(m->w), demi_scale(t->w, part)));
}
/* Solves all towers. Returns 0 if there are none. */
static int demi_towers_solve(dem_world *w) {
    demi_solver *s = &w->solver;
    int k;
    if (w->desc.planar || !w->bodies.shaped) return 0;
    demi_seats_find(w);
    demi_trees_order(s);
    for (k = 0; k < s->treed_count; k++) demi_tree_rise(w, s->treed[k]);
    for (k = s->treed_count; k-- > 0; ) demi_tree_load(s, s->treed[k]);
    for (k = 0; k < s->treed_count; k++) demi_tree_limit(s, s->treed[k]);
    for (k = 0; k < s->treed_count; k++) demi_tree_go(s, s->treed[k]);
    s->faced |= s->treed_count > 0 && s->trees[s->treed[s->treed_count - 1]].level > DEMI_TALL;
    return s->treed_count > 0;
}
