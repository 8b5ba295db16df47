/* ---------------------------------------------------------------------------------------------
   >>impulses
   In place of contact laws: rigid grains, and impulses that keep them out of each other ([TAS10],
   [STE96]). At the end of a step positions and velocities belong to one time. The next step's
   contacts are found half a step ahead (demi_ahead), at x + v dt/2: from there bodies go on by
   whole steps, so that the next places where contacts are found, a dt later, are those at which
   nothing may overlap. Every contact and gap nearer than the law's range is laid down here, and
   >>solvers looks for impulses so that after the next kick
       un + bias >= 0, push >= 0, one of the two 0;   bias = gap/dt, or e un before an impact;
       friction |T| <= mu push against the slip (DEM_CONE_COULOMB), or both together in the cone's
       own convex sense (DEM_CONE_CONVEX); rolling |R| <= mu_r R* push and twist |S| <= mu_s R* push
       against the relative spin, across the normal and about it.
   Cohesion pulls with its force from outside, so that push may be less than it; compliance C adds
   push C/dt^2 to bias: a spring 1/C, taken at the end of the step. Restitution is Newton's for
   every contact by itself (Moreau's convention for simultaneous ones): un after = -e un before, on
   closing contacts that would touch in the step, faster than what gravity brings in one.
   A meeting is laid down in two halves: who and where it is remembered, in the order of the lists;
   and what sweeps go over, by colours. Contacts of one colour share no body that moves, so threads
   take them in runs, and bits do not depend on how many threads there are.
   --------------------------------------------------------------------------------------------- */

/* A body: velocity and spin as the impulses found so far make them. inv 0: it goes as it is told.
   Behind the bodies each contact with a wall has one: the wall's surface there. */
typedef struct demi_mover { dem_real v[3], inv, w[3], inv_inertia; } demi_mover;
/* Two movers that meet; where it is remembered; its place among the contacts. */
typedef struct demi_meeting {
    int32_t a, b;
    int32_t home;                  /* entry of the near list; ~ that of its domain's kept */
    int32_t at;                    /* until it has a place: its colour */
} demi_meeting;
/* What sweeps go over. Impulses act on b; on a the opposite. Two cache lines. */
typedef struct demi_impulse {
    int32_t a, b;                  /* movers */
    dem_vec3 normal;               /* unit, a -> b */
    dem_real reach_a, reach_b;     /* m, of spheres: arms are reach_a n and -reach_b n */
    dem_vec3 slip;                 /* N s: friction */
    dem_real push, bias, mu;       /* N s; m/s */
    dem_real gn, gt;               /* 1/kg, what an impulse brings along the normal, and across */
    dem_real per_n, per_t;         /* kg: 1/(gn + compliance), 1/gt */
} demi_impulse;
/* Beside it. */
typedef struct demi_beside {
    dem_real gap, lift, pull, mass; /* m; kg m/s; N s; kg */
    dem_real turns;                /* m/s, <= 0: part of bias, see demi_impulse_turns */
    int bounces;                   /* bias is that of restitution */
} demi_beside;
/* Where there is rolling or spinning friction. */
typedef struct demi_twist {
    dem_vec3 moment;               /* N m s */
    dem_real per_roll, per_spin;   /* kg m2: 1/what a moment brings across the normal, about it */
    dem_real roll, spin;           /* m: limits of the moment over push */
} demi_twist;
enum { DEMI_COLOURS = 64, DEMI_SWEEP_RUN = 256 };
/* Overlap, of the radius, that is left as it is: what lies at rest is not stirred by undoing what
   the last digit of a solve has left. */
#define DEMI_LEFT DEM_R(5e-4)

/* Do impulses have a moment beside their force? */
static int demi_impulses_twist(const dem_world *w) {
    int i, j, twist = 0;
    for (i = 0; i < w->material_count; i++)
        for (j = i; j < w->material_count; j++) {
            const dem_pair *p = &w->pairs[i*DEMI_MATERIALS + j].given;
            twist |= p->rolling_friction > 0 || p->spinning_friction > 0;
        }
    return twist;
}
/* I^-1 x in the world's frame. */
DEM_INLINE dem_vec3 demi_tensor_times(const dem_real *t, dem_vec3 x) {
    return demi_v(t[0]*x.x + t[3]*x.y + t[4]*x.z, t[3]*x.x + t[1]*x.y + t[5]*x.z,
                  t[4]*x.x + t[5]*x.y + t[2]*x.z);
}
DEM_INLINE dem_vec3 demi_mover_turn(const demi_solver *s, int mover, dem_vec3 x, int shaped) {
    return shaped ? demi_tensor_times(s->tensors + 6*mover, x)
        : demi_scale(x, s->movers[mover].inv_inertia);
}
/* A mover gets a change of momentum, and of angular momentum. */
DEM_INLINE void demi_mover_push(const demi_solver *s, int mover, dem_vec3 p, dem_vec3 l,
                                int shaped) {
    demi_mover *m = s->movers + mover;
    dem_vec3 w;
    if (!(m->inv > 0)) return;
    w = demi_mover_turn(s, mover, l, shaped);
    m->v[0] += p.x*m->inv; m->v[1] += p.y*m->inv; m->v[2] += p.z*m->inv;
    m->w[0] += w.x; m->w[1] += w.y; m->w[2] += w.z;
}
/* A domain's bodies as they would go on without contacts; spins of bodies that are not spheres are
   those of their angular momentum. */
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
/* A joint as it acts in one step. */
typedef struct demi_rod {
    int32_t a, b, rows;            /* movers; rows 0: not in force */
    int32_t next[2];               /* joint of a, and of b, after this one; -1: none */
    int32_t knot, ends[2];         /* of the joint; of a and b, -1: it goes as it is told */
    int32_t stuck;                 /* of a motor that is at its limit: its sign; 0: none is */
    dem_vec3 arm[2];               /* m */
    dem_vec3 along[3];             /* unit: about which a may not turn against b; axis of a motor */
    dem_real before[6], given[6];  /* m/s, rad/s: of a against b; N s, N m s */
    dem_real give[6];              /* 1/kg, 1/(kg m2): softness, see DEMI_GIVE */
    dem_real most, torque;         /* N m s: of a motor; by one of torque */
} demi_rod;
/* A body that is held, or a joint in force, in the system that is solved for all of them. */
typedef struct demi_knot {
    int32_t mover, rod;            /* one of the two; the other is -1 */
    int32_t rank, order;           /* when it is eliminated; which is as the so-manieth */
    int32_t first, count;          /* its column: rows below the pivot */
    int32_t group;                 /* one of those that hang together; of that: */
    int32_t guarded, open;         /* may the joints give no energy? are some apart? 2: by
                                      somebody */
    int32_t excess, grounded;      /* joints less bodies; does one go to what is not solved for? */
    double work, bank, kinetic;    /* J */
    double x[6];                   /* right-hand side, and solution */
    dem_quat turned;               /* of a body: at the end of the step */
    int32_t links, waiting, degree, mark, paid;     /* while the order is sought */
} demi_knot;
typedef struct demi_link_of { int32_t to, next; } demi_link_of;
/* Softness of joints, of what an impulse brings; of those in loops, which may hold more than is
   needed: its square is above the last digit, so that pivots as small do no harm. How near the
   points shall come to each other, of the smallest radius. Of the kinetic energy, what joints may
   give back of what they have taken. */
#define DEMI_GIVE (DEMI_SINGLE ? DEM_R(1e-6) : DEM_R(1e-9))
#define DEMI_GIVE_LOOPS DEM_R(1e-6)
#define DEMI_JOINED (DEMI_SINGLE ? DEM_R(1e-6) : DEM_R(1e-8))
#define DEMI_BANKED 1e-3
/* Are these two joined, so that they do not touch? b < 0: wall. */
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
/* Whom a domain's bodies meet: spheres of the near list within the range, then contacts that are
   kept: of bodies that are no spheres, and with walls. */
static void demi_impulses_meet(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    const demi_kept *now = demi_kept_of(w, d);
    const size_t stride = (size_t)w->near.stride;
    demi_solver *s = &w->solver;
    demi_meeting *m = s->meetings + s->meeting_first[d];
    int p, e, i;
    for (p = demi_near_first(domain); p < domain->near_end; p = demi_near_next(domain, p)) {
        const size_t at = (size_t)d*stride + (size_t)p;
        const int a = w->near.a[at], b = w->near.b[at];
        dem_real *memory = w->near.memory + (size_t)d*DEMI_IMPULSE_REALS*stride + p;
        const dem_vec3 way = demi_near_way(w, at);
        const dem_real l2 = demi_dot(way, way), radii = w->bodies.pos[4*a + 3] +
            w->bodies.pos[4*b + 3], most = radii + demi_range(w, radii);
        if (l2 > 0 && l2 <= most*most && s->movers[a].inv + s->movers[b].inv > 0 &&
            !demi_joined(w, a, b, -1)) {
            m->a = a;
            m->b = b;
            m++->home = p;
        } else for (e = 0; e < DEMI_IMPULSE_REALS; e++) memory[(size_t)e*stride] = 0;
    }
    for (i = 0; i < domain->kept_next; i++) {
        demi_kept *k = w->kept_next + w->kept_first[d] + i;
        demi_kept_recall(w, now, k);
        k->force = demi_v(0, 0, 0);
        if (demi_kept_asked(w, k) && !demi_joined(w, k->a, k->b, k->wall) &&
            s->movers[k->a].inv + (k->b >= 0 ? s->movers[k->b].inv : 0) > 0) {
            m->a = k->a;
            m->b = k->b >= 0 ? k->b : w->bodies.count + w->kept_first[d] + i;
            m++->home = ~i;
        } else memset(k->memory, 0, sizeof k->memory);
    }
    s->meeting_count[d] = (int)(m - (s->meetings + s->meeting_first[d]));
}
/* Gives each meeting the first colour that neither of its bodies has, and its place in the order of
   colours. The last colour takes what finds none: it is swept by one thread. */
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
/* A unit vector across n (unit): [DUF17]. */
DEM_INLINE dem_vec3 demi_across(dem_vec3 n) {
    const dem_real s = n.z < 0 ? DEM_R(-1) : DEM_R(1), a = -1/(s + n.z);
    return demi_v(1 + s*n.x*n.x*a, s*n.x*n.y*a, -s*n.x);
}
/* What impulses bring at a contact: along the normal, across it, and by one along the other. */
typedef struct demi_brings { dem_real n, t, across, aside, roll, spin; } demi_brings;
/* Adds what they do to one body of any shape. Sizes across the normal: the largest there is. */
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
/* Friction that presses, or lifts: steps of push and slip are so short that they do not overshoot
   by what the other one brings (a rod that is pushed along, [PAI95]). */
static void demi_brings_bound(const dem_world *w, demi_brings *g, dem_real friction) {
    const dem_real mixed = DEMI_SQRT(g->across*g->across + g->aside*g->aside);
    const int convex = w->desc.cone == DEM_CONE_CONVEX;
    g->n += convex ? mixed : friction*mixed;
    g->t += convex ? mixed : 0;
}
/* Velocity of b relative to a where they meet, as bodies have it before the step. */
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
/* Geometry of a meeting, from either list. */
typedef struct demi_spot {
    dem_vec3 normal, arm_a, arm_b; /* unit, a -> b; m */
    dem_real gap, r_eff, size;     /* m; size: what gaps are compared with */
    int material;                  /* index, of b or the wall */
    const dem_real *memory;
    size_t stride;
} demi_spot;
static demi_spot demi_meeting_place(const dem_world *w, int d, const demi_meeting *m) {
    demi_spot o;
    if (m->home >= 0) {
        const size_t stride = (size_t)w->near.stride;
        const dem_vec3 way = demi_near_way(w, (size_t)d*stride + (size_t)m->home);
        const dem_real ra = w->bodies.pos[4*m->a + 3], rb = w->bodies.pos[4*m->b + 3];
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
        const demi_kept *k = w->kept_next + w->kept_first[d] + ~m->home;
        o.normal = k->normal;
        o.gap = -k->overlap;
        o.arm_a = k->arm_a;
        o.arm_b = k->arm_b;
        o.r_eff = k->r_eff;
        o.size = w->bodies.pos[4*k->a + 3];
        o.material = k->b < 0 ? w->walls[k->wall].material : w->bodies.material[k->b] - 1;
        o.memory = k->memory;
        o.stride = 1;
    }
    return o;
}
/* The surface of a wall, as a mover. */
static void demi_surface_lay(const dem_world *w, const demi_kept *k, demi_mover *m) {
    const demi_wall *wall = &w->walls[k->wall];
    const dem_vec3 x = demi_add(demi_at(w->bodies.pos + 4*k->a), k->shift);
    memset(m, 0, sizeof *m);
    demi_put(m->v, demi_surface_at(&wall->ahead, demi_add(x, k->arm_a)));
    demi_put(m->w, wall->ahead.spin);
}
/* Normals turn between two places where contacts are found. On a concave wall that alone makes a
   body close that moved along it. If half of that closing velocity is turned back, bodies move
   along chords from wall to wall and keep their energy; otherwise they would lose some in each
   step. A contact that lasts knows how much it is: closing now, less the normal velocity with which
   it was left (bodies still have that one; what a wall has changed its own by is no turn). Returns
   <= 0, m/s, to be added to the bias: never more than the contact closes by, so that it brings no
   energy. *hits: m/s, the rest of the closing velocity, which is an impact. */
static dem_real demi_impulse_turns(const dem_world *w, const demi_meeting *m, const demi_kept *k,
                                   const demi_spot *o, dem_real closing, dem_real *hits) {
    const dem_real *y = o->memory;
    dem_real turned = closing - y[8*o->stride];
    *hits = closing;
    if (!(y[6*o->stride] > 0) || !w->bodies.went[m->a] ||
        (m->b < w->bodies.count && !w->bodies.went[m->b])) return 0;
    if (!w->stage.forces_valid) {               /* the same step once more */
        if (y[9*o->stride] < 0) *hits = 0;
        return y[9*o->stride];
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
/* The coefficient of a meeting with this slip (m/s): static friction holds what did not slide in
   the last step. What did not push then begins now, and slides from the beginning where its slip is
   more than gravity gives in a step (`rest`, m/s) and round-off: else a whole impact would feel
   static friction, and how many did would depend on how far ahead they are seen. */
static dem_real demi_impulse_friction(const dem_world *w, const dem_pair *pair,
                                      const demi_spot *o, dem_vec3 slip, dem_real rest) {
    const dem_real slow = rest + (DEMI_SINGLE ? DEM_R(1e-5) : DEM_R(1e-10))*
        (dem_real)w->booked.speed_max;
    const int begins = !(o->memory[6*o->stride] > 0);
    const int slides = begins ? demi_dot(slip, slip) > slow*slow
        : o->memory[DEMI_IMPULSE_SLIDES*o->stride] > 0;
    return slides ? pair->friction : DEMI_MAX(pair->friction, pair->friction_static);
}
/* The second half of a domain's meetings: all that sweeps need. What is remembered is for turned
   normals: friction stays across them. Cohesion takes hold of what touches, to a millionth of the
   radius, and holds it up to a thousandth. */
static void demi_impulses_lay(dem_world *w, int d) {
    const demi_solver *s = &w->solver;
    const dem_real dt = s->dt, rest = (dem_real)demi_length(w->desc.gravity)*dt;
    const int shaped = w->bodies.shaped > 0;
    demi_domain *domain = &w->domains[d];
    int i;
    for (i = 0; i < s->meeting_count[d]; i++) {
        const demi_meeting *m = s->meetings + s->meeting_first[d] + i;
        const demi_kept *k = m->home < 0 ? w->kept_next + w->kept_first[d] + ~m->home : 0;
        const demi_spot o = demi_meeting_place(w, d, m);
        const dem_pair *pair = &w->pairs[(w->bodies.material[m->a] - 1)*DEMI_MATERIALS +
                                         o.material].given;
        const dem_real *y = o.memory;
        demi_impulse *c = s->contacts + m->at;
        demi_beside *beside = s->beside + m->at;
        /* a contact of several points has what its pair has once */
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
        mu = demi_impulse_friction(w, pair, &o, demi_sub(before, demi_scale(o.normal, closing)),
                                   rest);
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
        beside->bounces = pair->restitution > 0 && hits < -rest && o.gap + closing*dt <= 0;
        if (beside->bounces) { c->bias = pair->restitution*closing; beside->turns = 0; }
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
            /* nothing turns about an axis in the plane of a planar world */
            t->per_roll = g.roll > 0 ? 1/g.roll : 0;
            t->per_spin = g.spin > 0 ? 1/g.spin : 0;
            t->roll = pair->rolling_friction*o.r_eff;
            t->spin = pair->spinning_friction*o.r_eff;
        }
        domain->overlap = DEMI_MAX(domain->overlap, k ? (double)k->deep : (double)(-o.gap/o.size));
    }
}
