/* ---------------------------------------------------------------------------------------------
   >>impulses
   Contact constraints of rigid grains (non-smooth dynamics [TAS10], [STE96]): impulses, instead of
   contact laws, prevent overlap. This part sets up the constraints of a step and owns w->solver;
   >>solvers finds the impulses, >>impulses-told applies them.
   At the end of a step positions and velocities belong to the same time. Contacts of the next step
   are detected half a step ahead (demi_ahead), at x + v dt/2. From there bodies move by whole
   steps, so nothing may overlap at the next detection, dt later. Every pair with a gap below the
   range of the law becomes a constraint. The solver finds impulses such that after the next kick
       un + bias >= 0, push >= 0, one of the two 0;   bias = gap/dt, or e un before an impact;
       friction |T| <= mu push opposes the slip (DEM_CONE_COULOMB), or friction and normal impulse
       together obey the convex relaxation of the cone (DEM_CONE_CONVEX);
       rolling friction |R| <= mu_r R* push opposes the relative spin across the normal, and
       spinning friction |S| <= mu_s R* push that about the normal.
   Cohesion acts as an external attractive force, so the net normal impulse, push - pull, may be
   negative. Compliance C adds push C/dt^2 to bias: a spring of stiffness 1/C, evaluated at the end
   of the step. Restitution is Newton's, for each contact individually (Moreau's convention for
   simultaneous impacts): un after = -e un before, for contacts that would touch in the step and
   close faster than the speed that gravity adds in a step.
   A constraint is set up in two passes. The first lists its bodies and the location of its contact
   history, in the order of the neighbour lists. The second computes the data that sweeps read and
   write, ordered by colour (graph colouring). Contacts of one colour share no moving body, so
   threads sweep them in parallel, and results are bit-identical for any number of threads.
   --------------------------------------------------------------------------------------------- */

/* Solver body: velocity v, m/s, and spin w, rad/s, with the impulses found so far. inv: 1/kg; 0:
   its motion is prescribed. inv_inertia: 1/(kg m2), of spheres; other shapes use
   demi_solver.tensors. After the bodies the array has one entry per persistent contact (at a wall:
   the wall's surface at that contact), then one per joint (for an end at a wall or in space). */
typedef struct demi_mover { dem_real v[3], inv, w[3], inv_inertia; } demi_mover;
/* A contact constraint, first pass: two solver bodies and the location of the contact history. */
typedef struct demi_meeting {
    int32_t a, b;
    int32_t home;                  /* entry of the pruned neighbour list, or ~entry of the domain's
                                      persistent contacts */
    int32_t at;                    /* index in demi_solver.contacts; before that is known: colour */
    int32_t same;                  /* 1: with the body or joined walls of the constraint before */
} demi_meeting;
/* A contact constraint, second pass: what sweeps read and write, in two cache lines. Impulses are
   those on b; a gets the opposite. */
typedef struct demi_impulse {
    int32_t a, b;                  /* solver bodies */
    dem_vec3 normal;               /* unit, a -> b */
    dem_real reach_a, reach_b;     /* m, spheres only: lever arms are reach_a n and -reach_b n */
    dem_vec3 slip;                 /* N s, friction impulse */
    dem_real push, bias, mu;       /* N s, normal impulse; m/s, see above; friction coefficient */
    dem_real gn, gt;               /* 1/kg, inverse effective masses along and across the normal */
    dem_real per_n, per_t;         /* kg: 1/(gn + compliance/dt^2), 1/gt */
} demi_impulse;
/* Data of a contact constraint that sweeps do not read. */
typedef struct demi_beside {
    /* m, gap or overlap to correct (< 0); kg m/s, see demi_impulses_lift; N s, impulse of cohesion;
       kg, effective mass without rotation */
    dem_real gap, lift, pull, mass;
    dem_real turns;                /* m/s, <= 0: part of bias, see demi_impulse_turns */
    int holds;                     /* 1: of a seat of >>towers, and holds */
    int bounces;                   /* 1: bias is that of restitution */
    dem_real leaves;               /* m/s: of bodies that separate, the speed of approach at which
                                      a push does no work; else 0 */
} demi_beside;
/* Rolling and spinning friction of a contact, if any material has them. */
typedef struct demi_twist {
    dem_vec3 moment;               /* N m s, angular impulse on b */
    dem_real per_roll, per_spin;   /* kg m2, effective inertia across and about the normal */
    dem_real roll, spin;           /* m, limits of the moment divided by push */
    dem_vec3 by, way;              /* N m s: change of the last sweep, last direction */
} demi_twist;
/* Colours of contacts; contacts that a thread takes at a time. */
enum { DEMI_COLOURS = 64, DEMI_SWEEP_RUN = 256 };
/* Overlap, in radii, that is not corrected. It is larger than the error of a solve, so corrections
   do not disturb bodies at rest. */
#define DEMI_LEFT DEM_R(5e-4)

/* True if some pair of materials has rolling or spinning friction. */
static int demi_impulses_twist(const dem_world *w) {
    const demi_rubbing rub = demi_pairs_rub(w);
    return rub.rolling || rub.twisting;
}
/* Returns I^-1 x in the world frame; t: xx yy zz xy xz yz of I^-1. */
DEM_INLINE dem_vec3 demi_tensor_times(const dem_real *t, dem_vec3 x) {
    return demi_v(t[0]*x.x + t[3]*x.y + t[4]*x.z, t[3]*x.x + t[1]*x.y + t[5]*x.z,
                  t[4]*x.x + t[5]*x.y + t[2]*x.z);
}
/* Returns the change of spin, rad/s, that an angular impulse x (N m s) causes. */
DEM_INLINE dem_vec3 demi_mover_turn(const demi_solver *s, int mover, dem_vec3 x, int shaped) {
    return shaped ? demi_tensor_times(s->tensors + 6*mover, x)
        : demi_scale(x, s->movers[mover].inv_inertia);
}
/* Adds an impulse p (N s) and an angular impulse l (N m s) to a solver body, unless its motion is
   prescribed. */
DEM_INLINE void demi_mover_push(const demi_solver *s, int mover, dem_vec3 p, dem_vec3 l,
                                int shaped) {
    demi_mover *m = s->movers + mover;
    dem_vec3 w;
    if (!(m->inv > 0)) return;
    w = demi_mover_turn(s, mover, l, shaped);
    m->v[0] += p.x*m->inv; m->v[1] += p.y*m->inv; m->v[2] += p.z*m->inv;
    m->w[0] += w.x; m->w[1] += w.y; m->w[2] += w.z;
}
/* Returns the velocity of b relative to a at the contact, m/s, with the impulses found so far. */
DEM_INLINE dem_vec3 demi_impulse_velocity(const demi_solver *s, const demi_impulse *c, int shaped) {
    const demi_mover *a = s->movers + c->a, *b = s->movers + c->b;
    const dem_vec3 wa = demi_at(a->w), wb = demi_at(b->w);
    const dem_vec3 v = demi_sub(demi_at(b->v), demi_at(a->v));
    if (shaped) {
        const dem_vec3 *arms = s->arms + 2*(c - s->contacts);
        const dem_vec3 vb = b->inv > 0 ? demi_add(v, demi_cross(wb, arms[1])) : v;
        return demi_sub(vb, demi_cross(wa, arms[0]));
    }
    return demi_sub(v, demi_cross(demi_add(demi_scale(wa, c->reach_a), demi_scale(wb, c->reach_b)),
                                  c->normal));
}
/* Applies an impulse p, N s, to body b and the opposite to body a. */
DEM_INLINE void demi_impulse_apply(const demi_solver *s, const demi_impulse *c, dem_vec3 p,
                                   int shaped) {
    if (shaped) {
        const dem_vec3 *arms = s->arms + 2*(c - s->contacts);
        demi_mover_push(s, c->a, demi_scale(p, -1), demi_cross(p, arms[0]), 1);
        demi_mover_push(s, c->b, p, demi_cross(arms[1], p), 1);
    } else {
        const dem_vec3 l = demi_cross(p, c->normal);
        demi_mover_push(s, c->a, demi_scale(p, -1), demi_scale(l, c->reach_a), 0);
        demi_mover_push(s, c->b, p, demi_scale(l, c->reach_b), 0);
    }
}
/* Returns the impulse of a contact on b, N s. */
DEM_INLINE dem_vec3 demi_impulse_vector(const demi_impulse *c) {
    return demi_add(demi_scale(c->normal, c->push), c->slip);
}
/* Adds a change to an impulse. */
DEM_INLINE void demi_impulse_add(demi_impulse *c, dem_vec3 by) {
    const dem_real push = demi_dot(by, c->normal);
    c->push += push;
    c->slip = demi_add(c->slip, demi_sub(by, demi_scale(c->normal, push)));
}
/* Returns the angular momentum, N m s, of body i with spin w, rad/s. */
static dem_vec3 demi_body_turning(const dem_world *world, int i, dem_vec3 w) {
    const dem_quat q = demi_quat_at(world->bodies.orient + 4*i);
    const dem_vec3 I = demi_at(world->bodies.moment + 4*i), x = dem_quat_unrotate(q, w);
    if (!demi_shape_of(world, i)) return demi_scale(w, 1/world->bodies.inv_inertia[i]);
    return dem_quat_rotate(q, demi_v(I.x*x.x, I.y*x.y, I.z*x.z));
}
/* Returns the allowed rms residual without desc.tolerance: 0.05 g dt + 1e-5 times the largest
   speed + 1e-12 m/s. */
static double demi_solved_enough(const dem_world *w) {
    return 0.05*(double)demi_length(w->desc.gravity)*(double)w->clock.dt +
        1e-5*w->booked.speed_max + 1e-12;
}
/* Sets the solver bodies of a domain to the velocities that they would have after the step without
   contacts, and their inverse inertia tensors. Spins of bodies other than spheres follow from their
   angular momentum. */
static void demi_movers_lay(dem_world *w, int d) {
    const demi_solver *s = &w->solver;
    int i, k;
    for (i = w->domains[d].begin; i < w->domains[d].end; i++) {
        demi_mover *m = s->movers + i;
        const demi_lane b = demi_lane_move(w, i);
        const dem_real *torque = w->bodies.torque + 4*i;
        s->colours[i] = 0;
        m->inv = b.inv;
        m->inv_inertia = b.inv > 0 ? w->bodies.inv_inertia[i] : 0;
        for (k = 0; k < 4; k++) s->lifts[4*i + k] = 0;
        if (w->bodies.shaped && w->bodies.shape[i] && b.inv > 0) {
            const dem_quat q = demi_quat_at(w->bodies.orient + 4*i);
            const dem_vec3 I = demi_at(w->bodies.moment + 4*i);
            const dem_vec3 L = demi_at(w->bodies.angular + 4*i);
            const dem_vec3 inv = demi_v(1/I.x, 1/I.y, 1/I.z);
            const dem_vec3 x = dem_quat_rotate(q, demi_v(1, 0, 0));
            const dem_vec3 y = dem_quat_rotate(q, demi_v(0, 1, 0)), z = demi_cross(x, y);
            dem_real *t = s->tensors + 6*i;
            t[0] = inv.x*x.x*x.x + inv.y*y.x*y.x + inv.z*z.x*z.x;
            t[1] = inv.x*x.y*x.y + inv.y*y.y*y.y + inv.z*z.y*z.y;
            t[2] = inv.x*x.z*x.z + inv.y*y.z*y.z + inv.z*z.z*z.z;
            t[3] = inv.x*x.x*x.y + inv.y*y.x*y.y + inv.z*z.x*z.y;
            t[4] = inv.x*x.x*x.z + inv.y*y.x*y.z + inv.z*z.x*z.z;
            t[5] = inv.x*x.y*x.z + inv.y*y.y*y.z + inv.z*z.y*z.z;
            if (w->desc.planar) t[0] = t[1] = t[3] = t[4] = t[5] = 0;
            demi_put(w->bodies.spin + 4*i, demi_spin_of(q, L, inv));
            demi_put(m->w, demi_spin_of(q, demi_add(L, demi_scale(demi_at(torque), s->dt)), inv));
        } else {
            if (w->bodies.shaped) {
                memset(s->tensors + 6*i, 0, 6*sizeof *s->tensors);
                for (k = 0; k < 3; k++) s->tensors[6*i + k] = m->inv_inertia;
            }
            for (k = 0; k < 3; k++)
                m->w[k] = w->bodies.spin[4*i + k] + torque[k]*m->inv_inertia*s->dt;
        }
        for (k = 0; k < 3; k++)
            m->v[k] = b.inv > 0 ? b.v[k] + (b.f[k]*b.inv + b.g[k])*s->dt : b.v[k];
    }
}
/* The rows of one joint in one step (>>joints). */
typedef struct demi_rod {
    int32_t a, b, rows;            /* solver bodies; number of rows, 0: not in force */
    int32_t next[2];               /* next joint of a, and of b, see demi_solver.joined; -1: none */
    int32_t node, ends[2];         /* nodes of the joint, and of a and b; -1: prescribed motion */
    int32_t stuck;                 /* sign of the torque of a motor at its limit; 0: below it */
    dem_vec3 arm[2];               /* m, lever arms from the centres of a and b */
    dem_vec3 along[3];             /* unit axes of the spin rows: two across the hinge, its own */
    dem_real before[6], given[6];  /* m/s, rad/s, of a relative to b, before the step; N s, N m s,
                                      impulses on a */
    dem_real give[6];              /* 1/kg, 1/(kg m2): softness, see DEMI_GIVE */
    dem_real most, torque;         /* N m s: limit of a motor of speed; impulse of one of torque */
} demi_rod;
/* Node of the linear system of all joints: a movable body with joints, or a joint in force. */
typedef struct demi_joint_node {
    int32_t mover, rod;            /* solver body or joint; the other is -1 */
    int32_t rank, order;           /* its position in the order of elimination; order of entry i
                                      of the array: which node is eliminated at position i */
    int32_t first, count;          /* its column of the factor: entries of demi_solver.rows */
    int32_t group;                 /* a node of its group of connected nodes, at the end the root;
                                      the root has the values of the group: */
    int32_t guarded, open;         /* level of the energy guard, 0 to 2, see demi_joints_guard; bit
                                      0: some joint has a gap beyond `closed`, bit 1: some has one
                                      since the user moved a body */
    int32_t excess, grounded;      /* joints minus bodies; 1: a joint to a wall, space or a fixed
                                      body */
    double work, bank, kinetic;    /* J: work of its joints; energy that they have absorbed; kinetic
                                      energy of its bodies */
    double spare;                  /* J: the part of bank that displacements may spend */
    double wide, closed;           /* m: largest gap; largest one that impulses may close */
    double x[6];                   /* right-hand side, then solution */
    dem_quat turned;               /* of a body: orientation a step ahead, see demi_nodes_ahead */
    /* used by demi_nodes_order: neighbours; queue of nodes with a degree of this index; number of
       neighbours left; last node that marked it; see demi_node_ready */
    int32_t links, waiting, degree, mark, paid;
} demi_joint_node;
/* Entry of a linked list of nodes; next -1: the last. */
typedef struct demi_link_of { int32_t to, next; } demi_link_of;
/* DEMI_GIVE: softness of joints over the inverse effective mass. DEMI_GIVE_LOOPS: the same in
   loops, whose rows may be redundant; its square is above round-off, so pivots that small do no
   harm. DEMI_JOINED: tolerance for the gap of a joint, in smallest radii. DEMI_BANKED: part of the
   kinetic energy that joints may return after they have absorbed it.
   DEMI_EVEN: part of the impulses of joints that may close gaps. */
#define DEMI_GIVE (DEMI_SINGLE ? DEM_R(1e-6) : DEM_R(1e-9))
#define DEMI_GIVE_LOOPS DEM_R(1e-6)
#define DEMI_JOINED (DEMI_SINGLE ? DEM_R(1e-6) : DEM_R(1e-8))
#define DEMI_BANKED 1e-3
#define DEMI_EVEN 1e-5
/* True if a joint without `collide` connects bodies a and b (b < 0: body a and the wall), so that
   they do not touch each other. */
static int demi_joined(const dem_world *w, int a, int b, int wall) {
    int j, next;
    if (!w->joint_count) return 0;
    for (j = w->solver.joined[a]; j >= 0; j = next) {
        const demi_rod *r = w->solver.rods + j;
        next = r->next[r->a == a ? 0 : 1];
        if (w->joints[j].desc.collide) continue;
        if (b >= 0 ? (r->a == a ? r->b : r->a) == b
                   : !w->joints[j].desc.b.slot &&
                         w->joints[j].desc.wall.id == w->walls[wall].id) return 1;
    }
    return 0;
}
/* First pass over a domain: lists its contact constraints. These are pairs of spheres from the
   pruned neighbour list within the range, then persistent contacts: of other shapes, and with
   walls. Clears the contact history of pairs that are none. */
static void demi_impulses_meet(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    const demi_persistent *now = demi_persistent_of(w, d);
    const size_t stride = (size_t)w->near.stride;
    demi_solver *s = &w->solver;
    demi_meeting *m = s->meetings + s->meeting_first[d];
    const demi_persistent *last = 0;
    int p, e, i, run = 0;
    domain->faced = domain->seated = 0;
    for (p = demi_near_first(domain); p < domain->near_end; p = demi_near_next(domain, p)) {
        const size_t at = (size_t)d*stride + (size_t)p;
        const int a = w->near.a[at], b = w->near.b[at];
        dem_real *memory = w->near.memory + (size_t)d*DEMI_IMPULSE_REALS*stride + p;
        const dem_vec3 way = demi_near_level(w, at, demi_near_way(w, at));
        const dem_real l2 = demi_dot(way, way), radii = demi_radius(w, a) +
            demi_radius(w, b), most = radii + demi_range(w, radii);
        if (l2 > 0 && l2 <= most*most && s->movers[a].inv + s->movers[b].inv > 0 &&
            !demi_joined(w, a, b, -1)) {
            m->a = a;
            m->b = b;
            m->same = 0;
            m++->home = p;
            continue;
        }
        for (e = 0; e < DEMI_IMPULSE_REALS; e++) memory[(size_t)e*stride] = 0;
        if (!(l2 > 0) && s->movers[a].inv + s->movers[b].inv > 0 && !demi_joined(w, a, b, -1))
            domain->overlap = 2;                /* at the same position: there is no normal */
    }
    for (i = 0; i < domain->persistent_next; i++) {
        demi_persistent *k = w->persistent_next + w->persistent_first[d] + i;
        demi_persistent_recall(w, now, k);
        k->force = demi_v(0, 0, 0);
        if (demi_persistent_asked(w, k) && !demi_joined(w, k->a, k->b, k->wall) &&
            s->movers[k->a].inv + (k->b >= 0 ? s->movers[k->b].inv : 0) > 0) {
            m->a = k->a;
            m->b = k->b >= 0 ? k->b : w->bodies.count + w->persistent_first[d] + i;
            m->same = last && last->a == k->a && last->b == k->b && demi_persistent_one(w, last, k);
            m++->home = ~i;
            last = k;
            run = m[-1].same ? run + 1 : 1;
            domain->faced |= k->corners > 1;
            domain->seated |= run > 2;
        } else memset(k->memory, 0, sizeof k->memory);
    }
    s->meeting_count[d] = (int)(m - (s->meetings + s->meeting_first[d]));
}
/* Gives each constraint the first colour that neither of its bodies has, and its index in the order
   of colours. The last colour takes those that find none; one thread sweeps it. */
static void demi_impulses_colour(dem_world *w) {
    demi_solver *s = &w->solver;
    const int bodies = w->bodies.count;
    int at[DEMI_COLOURS], d, i, k;
    memset(s->begins, 0, sizeof s->begins);
    for (d = 0; d < w->domain_count; d++)
        for (i = 0; i < s->meeting_count[d]; i++) {
            demi_meeting *m = s->meetings + s->meeting_first[d] + i;
            const int a = s->movers[m->a].inv > 0, b = m->b < bodies && s->movers[m->b].inv > 0;
            const uint64_t taken = (a ? s->colours[m->a] : 0) | (b ? s->colours[m->b] : 0);
            for (k = 0; k < DEMI_COLOURS - 1 && taken >> k & 1; k++) continue;
            m->at = k;
            if (a) s->colours[m->a] |= UINT64_C(1) << k;
            if (b) s->colours[m->b] |= UINT64_C(1) << k;
            s->begins[k + 1]++;
        }
    for (k = 0; k < DEMI_COLOURS; k++) {
        s->begins[k + 1] += s->begins[k];
        at[k] = s->begins[k];
    }
    s->count = s->begins[DEMI_COLOURS];
    for (d = 0; d < w->domain_count; d++)
        for (i = 0; i < s->meeting_count[d]; i++) {
            demi_meeting *m = s->meetings + s->meeting_first[d] + i;
            m->at = at[m->at]++;
        }
}
/* Inverse effective masses of a contact: the change of relative velocity per unit impulse, 1/kg,
   along the normal (n) and across it (t), and in two directions across it by an impulse along the
   normal (across, aside); the change of relative spin, 1/(kg m2), across the normal (roll) and
   about it (spin). */
typedef struct demi_brings { dem_real n, t, across, aside, roll, spin; } demi_brings;
/* Adds those of one body of any shape. t takes the largest value of all directions across the
   normal, roll the larger one of two directions. */
static void demi_brings_add(const demi_solver *s, demi_brings *g, int body, dem_vec3 n,
                            dem_vec3 arm) {
    const dem_vec3 t = demi_across(n), u = demi_cross(n, t);
    const dem_vec3 an = demi_cross(arm, n), at = demi_cross(arm, t), au = demi_cross(arm, u);
    const dem_vec3 it = demi_mover_turn(s, body, at, 1), iu = demi_mover_turn(s, body, au, 1);
    const dem_vec3 rt = demi_mover_turn(s, body, t, 1), ru = demi_mover_turn(s, body, u, 1);
    const dem_real tt = demi_dot(at, it), uu = demi_dot(au, iu), tu = demi_dot(at, iu);
    const dem_real mean = (tt + uu)/2, half = (tt - uu)/2;
    if (!(s->movers[body].inv > 0)) return;
    g->n += s->movers[body].inv + demi_dot(an, demi_mover_turn(s, body, an, 1));
    g->across += demi_dot(an, it);
    g->aside += demi_dot(an, iu);
    g->t += s->movers[body].inv + mean + DEMI_SQRT(half*half + tu*tu);
    g->roll += DEMI_MAX(demi_dot(t, rt), demi_dot(u, ru));
    g->spin += demi_dot(n, demi_mover_turn(s, body, n, 1));
}
/* Increases n and t by the coupling of normal impulse and friction. Friction can press a contact or
   lift it (a rod that is pushed along, [PAI95]); with this, the steps of push and slip are so short
   that neither overshoots because of the other. */
static void demi_brings_bound(const dem_world *w, demi_brings *g, dem_real friction) {
    const dem_real mixed = DEMI_SQRT(g->across*g->across + g->aside*g->aside);
    const int convex = w->desc.cone == DEM_CONE_CONVEX;
    g->n += convex ? mixed : friction*mixed;
    g->t += convex ? mixed : 0;
}
/* Returns the velocity of b relative to a at the contact before the step, m/s. */
static dem_vec3 demi_impulse_before(const dem_world *w, const demi_impulse *c) {
    const demi_solver *s = &w->solver;
    const dem_vec3 *arms = w->bodies.shaped ? s->arms + 2*(c - s->contacts) : 0;
    const dem_vec3 arm_a = arms ? arms[0] : demi_scale(c->normal, c->reach_a);
    const dem_vec3 arm_b = arms ? arms[1] : demi_scale(c->normal, -c->reach_b);
    const dem_vec3 a = demi_velocity_at(w->bodies.vel, w->bodies.spin, c->a, arm_a);
    return demi_sub(c->b < w->bodies.count
                    ? demi_velocity_at(w->bodies.vel, w->bodies.spin, c->b, arm_b)
                    : demi_at(s->movers[c->b].v), a);
}
/* Geometry and contact history of a constraint, from either list. */
typedef struct demi_spot {
    dem_vec3 normal, arm_a, arm_b; /* unit, a -> b; m */
    dem_real gap, r_eff, size;     /* m; size: length that gaps are compared with */
    int material;                  /* index, of b or the wall */
    const dem_real *memory;        /* real e is memory[e*stride] */
    size_t stride;
} demi_spot;
/* Returns what is to be added to the gap of two bodies, m, if one was just set and is not half a
   step ahead: the gap is that at its time. The way between the centres is (demi_near_level), but
   the other body has turned. At walls contacts are those of that time, see `late`. */
static dem_real demi_meeting_late(const dem_world *w, const demi_meeting *m,
                                  const demi_persistent *k, const demi_spot *o) {
    const int late = k && k->b < 0 ? 0 : demi_pair_late(w, m->a, m->b);
    const int body = late > 0 ? m->a : m->b;
    if (!late) return 0;
    return demi_dot(demi_cross(demi_at(w->bodies.spin + 4*body), late > 0 ? o->arm_a : o->arm_b),
                    o->normal)*(dem_real)late*w->solver.dt/2;
}
/* Returns the geometry and the history of a constraint of domain d. */
static demi_spot demi_meeting_place(const dem_world *w, int d, const demi_meeting *m) {
    const demi_persistent *k = m->home < 0 ? w->persistent_next + w->persistent_first[d] + ~m->home
        : 0;
    demi_spot o;
    if (!k) {
        const size_t stride = (size_t)w->near.stride, at = (size_t)d*stride + (size_t)m->home;
        const dem_vec3 way = demi_near_level(w, at, demi_near_way(w, at));
        const dem_real ra = demi_radius(w, m->a), rb = demi_radius(w, m->b);
        const dem_real l = demi_length(way);
        o.normal = demi_scale(way, 1/l);
        o.gap = l - ra - rb;
        o.arm_a = demi_scale(o.normal, ra + o.gap/2);
        o.arm_b = demi_scale(o.normal, -(rb + o.gap/2));
        o.r_eff = ra*rb/(ra + rb);
        o.size = DEMI_MIN(ra, rb);
        o.material = w->bodies.material[m->b] - 1;
        o.memory = w->near.memory + (size_t)d*DEMI_IMPULSE_REALS*stride + m->home;
        o.stride = stride;
    } else {
        o.normal = k->normal;
        o.gap = -k->overlap/k->slope;           /* along the normal, m, whatever overlap means */
        o.arm_a = k->arm_a;
        o.arm_b = k->arm_b;
        o.r_eff = k->r_eff;
        o.size = demi_radius(w, k->a);
        if (k->b >= 0) o.size = DEMI_MIN(o.size, demi_radius(w, k->b));
        o.material = k->b < 0 ? w->walls[k->wall].material : w->bodies.material[k->b] - 1;
        o.memory = k->memory;
        o.stride = 1;
    }
    o.gap += demi_meeting_late(w, m, k, &o);
    return o;
}
/* Sets the solver body of a wall contact to the velocity of the wall's surface there. */
static void demi_surface_lay(const dem_world *w, const demi_persistent *k, demi_mover *m) {
    const demi_wall *wall = &w->walls[k->wall];
    const dem_vec3 x = demi_add(demi_at(w->bodies.pos + 4*k->a), k->shift);
    dem_vec3 v = demi_surface_at(&wall->ahead, demi_add(x, k->arm_a));
    memset(m, 0, sizeof *m);
    if (wall->glides) v = demi_add(v, demi_glide_at(wall, &wall->ahead, k->normal));
    demi_put(m->v, v);
    demi_put(m->w, wall->ahead.spin);
}
/* Returns the correction of bias for the rotation of the normal between two detections, m/s, <= 0.
   On a concave wall this rotation alone makes a body approach that moved along the wall. If half of
   that closing velocity is reversed, bodies move along chords from wall to wall and conserve
   energy; otherwise they would lose some in each step. In a lasting contact the part due to
   rotation is the closing velocity now, minus the normal velocity after the last step (which the
   bodies still have), minus the change of the wall's own velocity. The correction never exceeds the
   closing velocity, so it adds no energy. *hits receives the rest of the closing velocity, m/s,
   which is an impact. */
static dem_real demi_impulse_turns(const dem_world *w, const demi_meeting *m,
                                   const demi_persistent *k,
                                   const demi_spot *o, dem_real closing, dem_real *hits) {
    const dem_real *y = o->memory;
    dem_real turned = closing - y[8*o->stride];
    *hits = closing;
    if (!(y[6*o->stride] > 0) || !w->bodies.went[m->a] ||
        (m->b < w->bodies.count && !w->bodies.went[m->b])) return 0;
    if (!w->stage.forces_valid) {               /* the same step is solved again */
        *hits = closing - 2*y[9*o->stride];
        return closing < 0 ? DEMI_MAX(y[9*o->stride], closing) : 0;
    }
    if (k && k->b < 0) {
        const demi_wall *wall = &w->walls[k->wall];
        const dem_vec3 at = demi_add(demi_add(demi_at(w->bodies.pos + 4*k->a), k->shift), k->arm_a);
        turned -= demi_dot(demi_sub(demi_surface_at(&wall->ahead, at),
                                    demi_surface_at(&wall->was, at)), o->normal);
    }
    *hits = closing - turned;
    return turned < 0 && closing < 0 ? DEMI_MAX(turned/2, closing) : 0;
}
/* Returns the friction coefficient of a contact with this slip (m/s). Static friction acts on
   contacts that did not slide in the last step. A contact without normal impulse in the last step
   begins now; it slides from the beginning if its slip exceeds `rest`, m/s. Otherwise static
   friction would act during a whole impact, in a number of impacts that would depend on how early
   contacts are detected. */
static dem_real demi_impulse_friction(const dem_pair *pair, const demi_spot *o, dem_vec3 slip,
                                      dem_real rest) {
    const int begins = !(o->memory[6*o->stride] > 0);
    const int slides = begins ? demi_dot(slip, slip) > rest*rest
        : o->memory[DEMI_IMPULSE_SLIDES*o->stride] > 0;
    return slides ? pair->friction : DEMI_MAX(pair->friction, pair->friction_static);
}
/* Second pass over a domain: sets up all that sweeps need. Impulses of the last step are the
   initial guess, unless desc.cold_start is set; friction is projected onto the present tangent
   plane. Cohesion begins at gaps below a millionth of the radius and lasts up to a thousandth. */
static void demi_impulses_lay(dem_world *w, int d) {
    const demi_solver *s = &w->solver;
    /* bodies are at rest up to the speed that gravity adds in a step, and to round-off */
    const dem_real dt = s->dt, rest = (dem_real)demi_length(w->desc.gravity)*dt +
        (DEMI_SINGLE ? DEM_R(1e-5) : DEM_R(1e-10))*(dem_real)w->booked.speed_max;
    const int shaped = w->bodies.shaped > 0;
    demi_domain *domain = &w->domains[d];
    int i;
    for (i = 0; i < s->meeting_count[d]; i++) {
        const demi_meeting *m = s->meetings + s->meeting_first[d] + i;
        const demi_persistent *k = m->home < 0
            ? w->persistent_next + w->persistent_first[d] + ~m->home : 0;
        const demi_spot o = demi_meeting_place(w, d, m);
        const dem_pair *pair = &w->pairs[(w->bodies.material[m->a] - 1)*DEMI_MATERIALS +
                                         o.material].given;
        const dem_real *y = o.memory;
        demi_impulse *c = s->contacts + m->at;
        demi_beside *beside = s->beside + m->at;
        /* the points of a manifold share the compliance and cohesion of their pair */
        const dem_real points = (dem_real)(k && k->corners ? k->corners : 1);
        const dem_real give = pair->compliance*points, had = w->desc.cold_start ? 0 : dt;
        demi_brings g = {0, 0, 0, 0, 0, 0};
        dem_vec3 slip = demi_v(y[0], y[o.stride], y[2*o.stride]), before;
        dem_real mu, closing, hits;
        if (k && k->b < 0) demi_surface_lay(w, k, s->movers + m->b);
        c->a = m->a;
        c->b = m->b;
        c->normal = o.normal;
        if (shaped) {
            s->arms[2*m->at] = o.arm_a;
            s->arms[2*m->at + 1] = o.arm_b;
            demi_brings_add(s, &g, m->a, o.normal, o.arm_a);
            if (m->b < w->bodies.count) demi_brings_add(s, &g, m->b, o.normal, o.arm_b);
        } else {
            const demi_mover *a = s->movers + m->a, *b = s->movers + m->b;
            c->reach_a = demi_dot(o.arm_a, o.normal);
            c->reach_b = m->b < w->bodies.count ? -demi_dot(o.arm_b, o.normal) : 0;
            g.n = a->inv + b->inv;
            g.roll = g.spin = a->inv_inertia + b->inv_inertia;
            g.t = g.n + c->reach_a*c->reach_a*a->inv_inertia + c->reach_b*c->reach_b*b->inv_inertia;
        }
        before = demi_impulse_before(w, c);
        closing = demi_dot(before, o.normal);
        mu = demi_impulse_friction(pair, &o, demi_sub(before, demi_scale(o.normal, closing)), rest);
        if (shaped) demi_brings_bound(w, &g, mu);
        c->mu = mu;
        c->gn = g.n;
        c->gt = g.t;
        c->per_n = 1/(g.n + give/(dt*dt));
        c->per_t = 1/g.t;
        c->push = y[6*o.stride]*had;
        c->slip = demi_scale(demi_sub(slip, demi_scale(o.normal, demi_dot(slip, o.normal))), had);
        c->bias = (pair->compliance > 0 ? o.gap : DEMI_MAX(o.gap, 0))/dt;
        hits = closing;
        beside->turns = pair->compliance > 0 ? 0 : demi_impulse_turns(w, m, k, &o, closing, &hits);
        beside->bounces = pair->restitution > 0 && hits < -rest &&
            o.gap + closing*dt <= (DEMI_SINGLE ? DEM_R(1e-5) : DEM_R(1e-10))*o.size;
        if (beside->bounces) { c->bias = pair->restitution*closing; beside->turns = 0; }
        beside->leaves = closing > rest ? pair->restitution*closing : 0;
        c->bias += beside->turns;
        beside->gap = o.gap;
        if (o.gap < 0)
            beside->gap = pair->compliance > 0 ? 0 : DEMI_MIN(o.gap + DEMI_LEFT*o.size, 0);
        beside->lift = 0;
        beside->mass = 1/(s->movers[m->a].inv + s->movers[m->b].inv);
        beside->pull = o.gap < (y[6*o.stride] > 0 ? DEM_R(1e-3) : DEM_R(1e-6))*o.size
            ? pair->cohesion/points*dt : 0;
        if (s->twisted) {
            demi_twist *t = s->twists + m->at;
            t->moment = demi_scale(demi_v(y[3*o.stride], y[4*o.stride], y[5*o.stride]), had);
            /* in a planar world no body rotates about an axis in the plane */
            t->per_roll = g.roll > 0 ? 1/g.roll : 0;
            t->per_spin = g.spin > 0 ? 1/g.spin : 0;
            t->roll = pair->rolling_friction*o.r_eff;
            t->spin = pair->spinning_friction*o.r_eff;
        }
        domain->overlap = DEMI_MAX(domain->overlap, k ? (double)k->deep : (double)(-o.gap/o.size));
    }
}
