/* ---------------------------------------------------------------------------------------------
   >>integrators
   Time integration: kick, drift, and a prediction of the velocity for contact laws. Between steps
   pos, vel and force belong to the same time t_n; half_vel is the mean velocity of the last step,
   v(t_n - dt/2). Each scheme is one function over a range of bodies. `synced` = 0 means that the
   last half kick of the step before is still due; it is merged with the first one of this step, in
   the same arithmetic. Spins are integrated by the same scheme (with position Verlet: leapfrog).
   Bodies with three equal moments of inertia rotate with a constant spin between kicks. Moves
   w->bodies, and writes the speeds of rotation of work groups (turn, turn_rate, turn_speed).
   >>add-integrator: an enum value, a function here, a row in demi_integrator_rows.
   --------------------------------------------------------------------------------------------- */
/* True if forces depend on spins. demi_turns: also if bodies have orientations. Otherwise spins
   stay as they are: torques of contacts are round-off. */
static int demi_spins(const dem_world *w) {
    return w->desc.law || w->desc.body_force || w->effects.tangent != DEM_TANGENT_NONE ||
           w->effects.rolling != DEM_ROLLING_NONE || w->effects.twisting;
}
static int demi_turns(const dem_world *w) { return w->bodies.orienting || demi_spins(w); }

typedef struct demi_lane {           /* translation or rotation of one body */
    dem_real *v, *half, *f;          /* velocity, half-step velocity, force: 4 reals each */
    dem_real inv, g[3];              /* inverse mass or inertia; acceleration besides forces */
} demi_lane;

/* v(t + dt/2) = v(t - dt/2) + a dt, and the prediction v(t + dt) with constant a for contact laws.
   h is dt/2. */
DEM_INLINE void demi_kick_leapfrog(const demi_lane *b, dem_real h) {
    int k;
    for (k = 0; k < 3; k++) {
        const dem_real kick = (b->f[k]*b->inv + b->g[k])*h;
        const dem_real half = b->half[k] + 2*kick;
        b->half[k] = half;
        b->v[k] = half + kick;
    }
}
DEM_INLINE void demi_finish_half(const demi_lane *b, dem_real h) {
    int k;
    for (k = 0; k < 3; k++) b->v[k] = b->half[k] + (b->f[k]*b->inv + b->g[k])*h;
}

/* Returns the translation (demi_lane_move) or the rotation (demi_lane_turn) of a body, so that the
   schemes treat both alike. A fixed body has 1/mass 0 and no gravity. */
DEM_INLINE demi_lane demi_lane_move(const dem_world *w, int i) {
    demi_lane b;
    b.v = w->bodies.vel + 4*i; b.half = w->bodies.half_vel + 4*i; b.f = w->bodies.force + 4*i;
    b.inv = w->bodies.inv_mass[i];
    b.g[0] = b.inv > 0 ? w->desc.gravity.x : 0;
    b.g[1] = b.inv > 0 ? w->desc.gravity.y : 0;
    b.g[2] = b.inv > 0 ? w->desc.gravity.z : 0;
    return b;
}
DEM_INLINE demi_lane demi_lane_turn(const dem_world *w, int i) {
    demi_lane b;
    b.v = w->bodies.spin + 4*i; b.half = w->bodies.half_spin + 4*i; b.f = w->bodies.torque + 4*i;
    b.inv = w->bodies.inv_inertia[i];
    b.g[0] = b.g[1] = b.g[2] = 0;
    return b;
}

/* Velocity Verlet: x(t+dt) = x + dt (v + a dt/2): half kick, drift, prediction; the second half
   kick comes later. Loops include the fourth real of each body, so that compilers vectorise them:
   its velocity is 0, which leaves the radius in pos unchanged. */
static void demi_move_velocity_verlet(dem_world *w, int begin, int end, int turning) {
    const dem_real dt = w->clock.dt, h = (dem_real)w->clock.half_kick;
    const int synced = w->stage.synced;
    dem_real *DEMI_RESTRICT x = w->bodies.pos, *DEMI_RESTRICT v = w->bodies.vel,
        *DEMI_RESTRICT u = w->bodies.half_vel;
    const dem_real *DEMI_RESTRICT f = w->bodies.force, *DEMI_RESTRICT inv = w->bodies.inv_mass;
    dem_real g[4];
    int i, k;
    g[0] = w->desc.gravity.x; g[1] = w->desc.gravity.y; g[2] = w->desc.gravity.z; g[3] = 0;
    for (i = begin; i < end; i++) {
        const dem_real m = inv[i], free_fall = m > 0 ? DEM_R(1) : DEM_R(0);
        for (k = 4*i; k < 4*i + 4; k++) {
            const dem_real kick = (f[k]*m + g[k - 4*i]*free_fall)*h;
            const dem_real half = (synced ? v[k] : u[k] + kick) + kick;
            u[k] = half;
            v[k] = half + kick;
            x[k] += half*dt;
        }
    }
    if (!turning) return;
    v = w->bodies.spin; u = w->bodies.half_spin; f = w->bodies.torque; inv = w->bodies.inv_inertia;
    for (i = begin; i < end; i++)
        for (k = 4*i; k < 4*i + 4; k++) {
            const dem_real kick = f[k]*inv[i]*h, half = (synced ? v[k] : u[k] + kick) + kick;
            u[k] = half;
            v[k] = half + kick;
        }
}
/* Leapfrog: v(t+dt/2) = v(t-dt/2) + a dt, x(t+dt) = x + v(t+dt/2) dt */
static void demi_move_leapfrog(dem_world *w, int begin, int end, int turning) {
    const dem_real dt = w->clock.dt, h = (dem_real)w->clock.half_kick;
    int i, k;
    for (i = begin; i < end; i++) {
        const demi_lane b = demi_lane_move(w, i);
        demi_kick_leapfrog(&b, h);
        for (k = 0; k < 3; k++) w->bodies.pos[4*i + k] += b.half[k]*dt;
    }
    if (!turning) return;
    for (i = begin; i < end; i++) {
        const demi_lane b = demi_lane_turn(w, i);
        demi_kick_leapfrog(&b, h);
    }
}
/* Position Verlet: x(t+dt) = 2 x(t) - x(t-dt) + a dt^2 [ALK07] eq 2.3; v from differences of
   positions, predicted with a */
static void demi_move_position_verlet(dem_world *w, int begin, int end, int turning) {
    const dem_real dt = w->clock.dt, h = (dem_real)w->clock.half_kick;
    int i, k;
    for (i = begin; i < end; i++) {
        const demi_lane b = demi_lane_move(w, i);
        for (k = 0; k < 3; k++) {
            const dem_real a = b.f[k]*b.inv + b.g[k], x = w->bodies.pos[4*i + k];
            const dem_real next = 2*x - w->bodies.last_pos[4*i + k] + a*dt*dt;
            b.half[k] = (next - x)/dt;
            b.v[k] = b.half[k] + a*h;
            w->bodies.last_pos[4*i + k] = x;
            w->bodies.pos[4*i + k] = next;
        }
    }
    if (!turning) return;
    for (i = begin; i < end; i++) {
        const demi_lane b = demi_lane_turn(w, i);
        demi_kick_leapfrog(&b, h);
    }
}
/* Symplectic Euler: v(t+dt) = v + a dt, x(t+dt) = x + v(t+dt) dt */
static void demi_move_symplectic_euler(dem_world *w, int begin, int end, int turning) {
    const dem_real dt = w->clock.dt;
    int i, k;
    for (i = begin; i < end; i++) {
        const demi_lane b = demi_lane_move(w, i), s = demi_lane_turn(w, i);
        for (k = 0; k < 3; k++) {
            b.half[k] = b.v[k] += (b.f[k]*b.inv + b.g[k])*dt;
            w->bodies.pos[4*i + k] += b.v[k]*dt;
            if (turning) s.half[k] = s.v[k] += s.f[k]*s.inv*dt;
        }
    }
}
/* Forward Euler: x(t+dt) = x + v(t) dt, v(t+dt) = v + a dt [MIL] 4.6 */
static void demi_move_forward_euler(dem_world *w, int begin, int end, int turning) {
    const dem_real dt = w->clock.dt;
    int i, k;
    for (i = begin; i < end; i++) {
        const demi_lane b = demi_lane_move(w, i), s = demi_lane_turn(w, i);
        for (k = 0; k < 3; k++) {
            b.half[k] = b.v[k];
            w->bodies.pos[4*i + k] += b.v[k]*dt;
            b.v[k] += (b.f[k]*b.inv + b.g[k])*dt;
            s.half[k] = s.v[k];
            if (turning) s.v[k] += s.f[k]*s.inv*dt;
        }
    }
}
/* Midpoint rule, for impulses: x(t+dt) = x + (v(t) + v(t+dt)) dt/2, v(t+dt) = v + a(t+dt/2) dt,
   with contacts detected at x + v dt/2. A velocity that the user has set may point into a wall or
   part a joint. In the first step after that (`went` 0) contacts are detected at x, and the
   impulses change the velocity before the body moves. */
static void demi_move_midpoint(dem_world *w, int begin, int end, int turning) {
    const dem_real dt = w->clock.dt;
    int i, k;
    demi_move_velocity_verlet(w, begin, end, turning);
    for (i = begin; i < end; i++)
        for (k = 4*i; k < 4*i + 3 && !w->bodies.went[i]; k++) {
            w->bodies.pos[k] += (w->bodies.vel[k] - w->bodies.half_vel[k])*dt;
            w->bodies.half_vel[k] = w->bodies.vel[k];
            w->bodies.half_spin[k] = w->bodies.spin[k];
        }
}
static void demi_finish_nothing(dem_world *w, int begin, int end) { (void)w; (void)begin;
    (void)end; }
/* Second half kick, for schemes whose velocities are at the half step. */
static void demi_finish_halves(dem_world *w, int begin, int end) {
    const dem_real h = (dem_real)w->clock.half_kick;
    const int turning = demi_turns(w);
    int i;
    for (i = begin; i < end; i++) {
        const demi_lane b = demi_lane_move(w, i), s = demi_lane_turn(w, i);
        demi_finish_half(&b, h);
        if (turning) demi_finish_half(&s, h);
    }
}
/* For the ledger: stores in `late` by how much the velocities used by contact laws were too low,
   m/s. With x''' = j the prediction is too low by j dt^2/2, and the final velocity of the step, the
   central difference of three positions, is too high by j dt^2/6. At two thirds of the way from the
   first to the second the errors of second order cancel, both in the losses of dashpots and in the
   work of springs. */
static void demi_late_note(dem_world *w, int begin, int end) {
    const dem_real h = (dem_real)w->clock.half_kick, part = DEM_R(2.0)/3;
    const dem_real *DEMI_RESTRICT v = w->bodies.vel, *DEMI_RESTRICT u = w->bodies.half_vel;
    const dem_real *DEMI_RESTRICT f = w->bodies.force, *DEMI_RESTRICT inv = w->bodies.inv_mass;
    dem_real *DEMI_RESTRICT late = w->bodies.late, g[4];
    int i, k;
    g[0] = w->desc.gravity.x; g[1] = w->desc.gravity.y; g[2] = w->desc.gravity.z; g[3] = 0;
    for (i = begin; i < end; i++) {
        const dem_real m = inv[i], free_fall = m > 0 ? DEM_R(1) : DEM_R(0);
        for (k = 4*i; k < 4*i + 4; k++)
            late[k] = (u[k] - v[k] + (f[k]*m + g[k - 4*i]*free_fall)*h)*part;
    }
}
/* Sets half_vel, half_spin and what depends on them for the first step from a state at time t. */
static void demi_prime_body(dem_world *w, int i) {
    const dem_real dt = w->clock.dt, h = dt/2;
    const demi_lane b = demi_lane_move(w, i), s = demi_lane_turn(w, i);
    const int turning = demi_turns(w);
    int k;
    for (k = 0; k < 3; k++) {
        const dem_real a = b.f[k]*b.inv + b.g[k];
        b.half[k] = b.v[k] - a*h;
        if (w->bodies.backward) w->bodies.last_pos[4*i + k] = w->bodies.pos[4*i + k] - b.half[k]*dt;
        s.half[k] = turning ? s.v[k] - s.f[k]*s.inv*h : s.v[k];
    }
    if (w->bodies.shaped && w->bodies.shape[i])
        demi_put(w->bodies.angular + 4*i, demi_sub(demi_angular_of(w, i),
                          demi_scale(demi_at(w->bodies.torque + 4*i),
                                     demi_response_is(w, DEMI_MIDWAY) ? 0 : h)));
}
static void demi_prime(dem_world *w) {
    int i;
    for (i = 0; i < w->bodies.count; i++) demi_prime_body(w, i);
    w->stage.primed = 1;
}
/* --- rotation. The spin of a sphere is integrated by the scheme of its translation; with
       desc.orientations, its orientation follows from the spin. Other bodies store their angular
       momentum in the world frame, L(t - dt/2), which torques kick: L(t + dt/2) = L(t - dt/2) +
       T(t) dt. Between kicks the body rotates freely from q(t) with L to q(t + dt), by one of the
       functions below, which leave L unchanged to the bit. Contact laws use half_spin, the mean
       over the step, and spin, predicted with the last torque. All functions are of second order
       under torques. Tests: free rotation against elliptic functions, order, tops. --- */

#if defined(__GNUC__) && !defined(__clang__) && !defined(__TINYC__)
#pragma GCC push_options
#pragma GCC optimize("no-trapping-math")
#endif
/* Returns the rotation by the vector v (rad), |v| < 2: exp(v/2), by series to 1e-12. */
DEM_INLINE dem_quat demi_quat_exp(dem_vec3 v) {
    const dem_real x = demi_dot(v, v)*DEM_R(0.25);         /* (half angle)^2 */
    /* cos and half of sin x/x, as products: compilers do not turn divisions into products */
    const dem_real c = 1 + x*(DEM_R(-1.0/2) + x*(DEM_R(1.0/24) + x*(DEM_R(-1.0/720) +
        x*(DEM_R(1.0/40320) + x*(DEM_R(-1.0/3628800) + x*DEM_R(1.0/479001600))))));
    const dem_real s = DEM_R(0.5) + x*(DEM_R(-1.0/12) + x*(DEM_R(1.0/240) + x*(DEM_R(-1.0/10080) +
        x*(DEM_R(1.0/725760) + x*(DEM_R(-1.0/79833600) + x*DEM_R(1.0/12454041600.0))))));
    return dem_quat_make(c, s*v.x, s*v.y, s*v.z);
}
/* Normalises a quaternion that is nearly a unit one; cheaper than demi_quat_unit, for kernels. */
DEM_INLINE dem_quat demi_quat_again(dem_quat q) {
    const dem_real l = 1/DEMI_SQRT(q.w*q.w + q.x*q.x + q.y*q.y + q.z*q.z);
    return dem_quat_make(q.w*l, q.x*l, q.y*l, q.z*l);
}
/* Free rotation by SPIRAL [SPI24], modified to conserve angular momentum. The original advances w
   from one half step to the next by a third-order Runge-Kutta step that includes the torque, and q
   by q exp(dt w/2); both lose some L in every step. Here the torque acts in the kick only, and the
   body rotates freely in between. Taylor series of w to third order, with w' = I^-1 (I w x w), give
   its mean and its end,
       mean = w + h w'/2 + h^2 w''/6 + h^3 w'''/24,   end = w + h w' + h^2 w''/2 + h^3 w'''/6.
   q is rotated by the mean and the first term of the Magnus expansion, h (w x end)/12, and then by
   the small rotation that makes I end parallel to R^T L. This removes two of the three error
   components of q and keeps L and |q| exact. Free rotation is of order 3 in q. At |w| h = 0.1 the
   error is 10 times smaller than that of the original, and the energy drift 9 times
   (derivation: docs/theory_surfaces.md). I, inv: principal moments and their inverses. Returns the
   mean spin in the body frame, rad/s. */
DEM_INLINE dem_vec3 demi_flight_spiral(dem_quat *q, dem_vec3 L, dem_vec3 I, dem_vec3 inv,
                                       dem_real h) {
    const dem_vec3 m = dem_quat_unrotate(*q, L);
    const dem_vec3 w = demi_v(m.x*inv.x, m.y*inv.y, m.z*inv.z);
    const dem_vec3 a = demi_v((I.y - I.z)*inv.x, (I.z - I.x)*inv.y, (I.x - I.y)*inv.z);
    const dem_vec3 w1 = demi_v(a.x*w.y*w.z, a.y*w.z*w.x, a.z*w.x*w.y);
    const dem_vec3 w2 = demi_v(a.x*(w1.y*w.z + w.y*w1.z), a.y*(w1.z*w.x + w.z*w1.x),
                               a.z*(w1.x*w.y + w.x*w1.y));
    const dem_vec3 w3 = demi_v(a.x*(w2.y*w.z + 2*w1.y*w1.z + w.y*w2.z),
                               a.y*(w2.z*w.x + 2*w1.z*w1.x + w.z*w2.x),
                               a.z*(w2.x*w.y + 2*w1.x*w1.y + w.x*w2.y));
    /* products of angular momenta would underflow in single precision: angles per step */
    const dem_real unit = DEMI_SINGLE ? inv.x*h : 1;
    const dem_vec3 turn = demi_scale(L, unit);
    const dem_real ll = demi_dot(turn, turn);
    dem_vec3 mean, end, g, c, magnus;
    end = demi_scale(demi_add(w2, demi_scale(w3, h*DEM_R(1.0/3))), h*h*DEM_R(0.5));
    mean = demi_scale(demi_add(w2, demi_scale(w3, h*DEM_R(0.25))), h*h*DEM_R(1.0/6));
    end = demi_add(w, demi_add(demi_scale(w1, h), end));
    mean = demi_add(w, demi_add(demi_scale(w1, h*DEM_R(0.5)), mean));
    magnus = demi_scale(demi_cross(w, end), h*DEM_R(1.0/12));
    *q = dem_quat_multiply(*q, demi_quat_exp(demi_scale(demi_add(mean, magnus), h)));
    end = demi_scale(demi_v(I.x*end.x, I.y*end.y, I.z*end.z), unit);
    g = dem_quat_unrotate(*q, turn);
    c = demi_scale(demi_cross(end, g), ll > DEMI_TINY ? DEM_R(0.5)/ll : 0);
    *q = demi_quat_again(dem_quat_multiply(*q, dem_quat_make(1, c.x, c.y, c.z)));
    return demi_add(mean, magnus);
}
/* Free rotation by [FIN92]. Half an Euler step gives q in the middle of the step; L and that q give
   w there; a whole step with that w gives q at the end. [RUB15] eq 17 to 21 uses it with w instead
   of L, which is the same for spheroids that do not spin about their axis. */
static dem_vec3 demi_flight_fincham(dem_quat *q, dem_vec3 L, dem_vec3 I, dem_vec3 inv, dem_real h) {
    const dem_quat start = *q;
    dem_vec3 m = dem_quat_unrotate(start, L), w = demi_v(m.x/I.x, m.y/I.y, m.z/I.z);
    dem_quat mid, by;
    (void)inv;
    by = dem_quat_multiply(start, dem_quat_make(0, w.x*h/4, w.y*h/4, w.z*h/4));
    mid = demi_quat_unit(dem_quat_make(start.w + by.w, start.x + by.x, start.y + by.y,
                                       start.z + by.z));
    m = dem_quat_unrotate(mid, L);
    w = demi_v(m.x/I.x, m.y/I.y, m.z/I.z);
    by = dem_quat_multiply(mid, dem_quat_make(0, w.x*h/2, w.y*h/2, w.z*h/2));
    *q = demi_quat_unit(dem_quat_make(start.w + by.w, start.x + by.x, start.y + by.y,
                                      start.z + by.z));
    return dem_quat_unrotate(start, dem_quat_rotate(mid, w));
}
/* Free rotation by the splitting of NO_SQUISH [DLM97]: exact rotations about x, y, z, y, x in turn.
   It is symplectic: the energy oscillates and does not drift. */
static dem_vec3 demi_flight_splitting(dem_quat *q, dem_vec3 L, dem_vec3 I, dem_vec3 inv,
                                      dem_real h) {
    static const int order[5] = {0, 1, 2, 1, 0};
    const dem_quat start = *q;
    dem_vec3 m = dem_quat_unrotate(start, L), w0 = demi_v(m.x/I.x, m.y/I.y, m.z/I.z), w1;
    int k;
    (void)inv;
    for (k = 0; k < 5; k++) {
        const double step = (double)(k == 2 ? h : h/2);
        const double rate = order[k] == 0 ? (double)(m.x/I.x) : order[k] == 1 ? (double)(m.y/I.y)
            : (double)(m.z/I.z);
        const dem_real c = (dem_real)demi_cos(rate*step/2), s = (dem_real)demi_sin(rate*step/2);
        const dem_quat r = dem_quat_make(c, order[k] == 0 ? s : 0, order[k] == 1 ? s : 0,
                                         order[k] == 2 ? s : 0);
        *q = dem_quat_multiply(*q, r);
        m = dem_quat_unrotate(r, m);
    }
    *q = demi_quat_unit(*q);
    m = dem_quat_unrotate(*q, L);
    w1 = demi_v(m.x/I.x, m.y/I.y, m.z/I.z);
    return demi_scale(demi_add(w0, dem_quat_unrotate(start, dem_quat_rotate(*q, w1))), DEM_R(0.5));
}
typedef struct demi_rotation_row {
    const char *name;
    dem_vec3 (*fly)(dem_quat *q, dem_vec3 L, dem_vec3 I, dem_vec3 inv, dem_real h);
} demi_rotation_row;
static const demi_rotation_row demi_rotation_rows[] = {         /* in the order of dem_rotation */
    {"SPIRAL", demi_flight_spiral},
    {"Fincham", demi_flight_fincham},
    {"NO_SQUISH", demi_flight_splitting},
};
enum { DEMI_ROTATIONS = (int)(sizeof demi_rotation_rows/sizeof *demi_rotation_rows) };
/* Returns the spin of a body with angular momentum L, world frame, rad/s. */
DEM_INLINE dem_vec3 demi_spin_of(dem_quat q, dem_vec3 L, dem_vec3 inv) {
    const dem_vec3 m = dem_quat_unrotate(q, L);
    return dem_quat_rotate(q, demi_v(m.x*inv.x, m.y*inv.y, m.z*inv.z));
}

/* A tile of rotating bodies, as a structure of arrays that compilers can vectorise: orientations,
   angular momenta, torques, principal moments with moment_arm, and results. */
typedef struct demi_turning {
    dem_real q[4][DEMI_ROOM], L[3][DEMI_ROOM], T[3][DEMI_ROOM], I[4][DEMI_ROOM];
    dem_real half[3][DEMI_ROOM], spin[3][DEMI_ROOM];
    dem_real speed2[DEMI_ROOM], change2[DEMI_ROOM];        /* (m/s)^2, at the end of moment_arm */
    dem_real rate2[DEMI_ROOM];                            /* (rad/s)^2 */
    int round;                     /* 1: the three moments of each body are equal */
} demi_turning;
enum { DEMI_ROTATION_ROUND = -1 };             /* beside dem_rotation: a constant spin */
/* Body l of a tile: kicks L by T kick, rotates freely for dt, and predicts spin with L + T after.
   Also stores the squares of its speed and change of speed. rotation: a dem_rotation, or
   DEMI_ROTATION_ROUND. */
DEM_INLINE void demi_turning_fly(demi_turning *t, int l, int rotation, dem_real kick, dem_real dt,
                                 dem_real after) {
    dem_quat q = dem_quat_make(t->q[0][l], t->q[1][l], t->q[2][l], t->q[3][l]), start = q;
    const dem_vec3 T = demi_v(t->T[0][l], t->T[1][l], t->T[2][l]);
    const dem_vec3 I = demi_v(t->I[0][l], t->I[1][l], t->I[2][l]);
    const dem_vec3 inv = demi_v(1/I.x, 1/I.y, 1/I.z);
    const dem_vec3 L = demi_v(t->L[0][l] + T.x*kick, t->L[1][l] + T.y*kick,
                              t->L[2][l] + T.z*kick), next = demi_add(L, demi_scale(T, after));
    dem_vec3 half, spin, by;
    if (rotation == DEMI_ROTATION_ROUND) {
        half = demi_scale(L, inv.x);
        spin = demi_scale(next, inv.x);
        q = demi_quat_again(dem_quat_multiply(demi_quat_exp(demi_scale(half, dt)), q));
    } else {
        half = dem_quat_rotate(start, rotation == DEM_ROTATION_SPIRAL
            ? demi_flight_spiral(&q, L, I, inv, dt)
            : demi_rotation_rows[rotation].fly(&q, L, I, inv, dt));
        spin = demi_spin_of(q, next, inv);
    }
    by = demi_sub(spin, half);                  /* half a step's change */
    t->rate2[l] = demi_dot(half, half);
    t->speed2[l] = t->rate2[l]*t->I[3][l]*t->I[3][l];
    t->change2[l] = 4*demi_dot(by, by)*t->I[3][l]*t->I[3][l];
    t->q[0][l] = q.w; t->q[1][l] = q.x; t->q[2][l] = q.y; t->q[3][l] = q.z;
    t->L[0][l] = L.x; t->L[1][l] = L.y; t->L[2][l] = L.z;
    t->half[0][l] = half.x; t->half[1][l] = half.y; t->half[2][l] = half.z;
    t->spin[0][l] = spin.x; t->spin[1][l] = spin.y; t->spin[2][l] = spin.z;
}
/* The default scheme for a whole tile, without a branch inside, so that it is vectorised. */
DEMI_CLONES static void demi_turning_spiral(demi_turning *t, int count, dem_real kick, dem_real dt,
                                            dem_real after) {
    DEMI_ROWS(count) demi_turning_fly(t, q, DEM_ROTATION_SPIRAL, kick, dt, after); DEMI_ROWS_END
}
/* The same for bodies with three equal moments, whose free rotation is a constant spin. */
DEMI_CLONES static void demi_turning_round(demi_turning *t, int count, dem_real kick, dem_real dt,
                                           dem_real after) {
    DEMI_ROWS(count) demi_turning_fly(t, q, DEMI_ROTATION_ROUND, kick, dt, after); DEMI_ROWS_END
}
#if defined(__GNUC__) && !defined(__clang__) && !defined(__TINYC__)
#pragma GCC pop_options
#endif
static void demi_turning_all(const dem_world *w, demi_turning *t, int count, dem_real kick,
                             dem_real dt, dem_real after) {
    int l;
    if (t->round) demi_turning_round(t, count, kick, dt, after);
    else if (w->desc.rotation == DEM_ROTATION_SPIRAL)
        demi_turning_spiral(t, count, kick, dt, after);
    else for (l = 0; l < count; l++)
        demi_turning_fly(t, l, (int)w->desc.rotation, kick, dt, after);
}
/* How bodies rotate: over a whole step, with springs; over two halves with a kick in between, with
   impulses; over half a step without a kick, for contact detection with impulses (demi_ahead). */
enum { DEMI_TURN_STEP, DEMI_TURN_HALVES, DEMI_TURN_AHEAD };
/* True if the default scheme rotates a body whose three moments of inertia are equal, as those of a
   ball or a cube: its free rotation has a constant spin. */
DEM_INLINE int demi_turns_round(const dem_world *w, int i) {
    const dem_real *I = w->bodies.moment + 4*(size_t)i;
    return I[0] == I[1] && I[1] == I[2] && w->desc.rotation == DEM_ROTATION_SPIRAL;
}
/* Rotates the listed bodies other than spheres, at most a tile. demi_turns_round must be the same
   for all of them. Unless `domain` is null, it receives the largest speeds of rotation and their
   changes. */
static void demi_orient_some(dem_world *w, demi_domain *domain, const int *who, int count,
                             int how) {
    const dem_real dt = w->clock.dt;
    demi_turning t;
    int l, e;
    const int full = (count + DEMI_LANES - 1)/DEMI_LANES*DEMI_LANES;
    dem_real turn = 0, speed = 0, rate = 0, check = 0;
    t.round = demi_turns_round(w, who[0]);
    for (l = 0; l < full; l++) {                /* padded with copies of the last one */
        size_t i = 4*(size_t)who[DEMI_MIN(l, count - 1)];
        DEMI_ONE_BY_ONE(i);
        for (e = 0; e < 4; e++) t.q[e][l] = w->bodies.orient[i + (size_t)e];
        for (e = 0; e < 4; e++) t.I[e][l] = w->bodies.moment[i + (size_t)e];
        for (e = 0; e < 3; e++) t.L[e][l] = w->bodies.angular[i + (size_t)e];
        for (e = 0; e < 3; e++) t.T[e][l] = w->bodies.torque[i + (size_t)e];
        if (how == DEMI_TURN_HALVES && !w->bodies.went[i/4])    /* as in demi_move_midpoint */
            for (e = 0; e < 3; e++) { t.L[e][l] += t.T[e][l]*dt; t.T[e][l] = 0; }
    }
    if (how == DEMI_TURN_STEP) demi_turning_all(w, &t, full, dt, dt, dt/2);
    else demi_turning_all(w, &t, full, 0, dt/2, 0);
    if (how == DEMI_TURN_HALVES) {
        demi_turning first = t;
        demi_turning_all(w, &t, full, dt, dt/2, 0);
        for (l = 0; l < count; l++) {
            dem_real change2 = 0;
            for (e = 0; e < 3; e++) {
                const dem_real by = t.spin[e][l] - first.half[e][l];
                change2 += by*by;
                t.half[e][l] = (first.half[e][l] + t.half[e][l])/2;
            }
            t.change2[l] = 4*change2*t.I[3][l]*t.I[3][l];
            t.speed2[l] = DEMI_MAX(t.speed2[l], first.speed2[l]);
            t.rate2[l] = DEMI_MAX(t.rate2[l], first.rate2[l]);
        }
    }
    for (l = 0; l < count; l++) {
        size_t i = 4*(size_t)who[l];
        DEMI_ONE_BY_ONE(i);
        for (e = 0; e < 4; e++) w->bodies.orient[i + (size_t)e] = t.q[e][l];
        for (e = 0; e < 3; e++) w->bodies.angular[i + (size_t)e] = t.L[e][l];
        for (e = 0; e < 3 && how != DEMI_TURN_AHEAD; e++)
            w->bodies.half_spin[i + (size_t)e] = t.half[e][l];
        for (e = 0; e < 3; e++) w->bodies.spin[i + (size_t)e] = t.spin[e][l];
        turn = DEMI_MAX(turn, t.change2[l]);
        speed = DEMI_MAX(speed, t.speed2[l]);
        rate = DEMI_MAX(rate, t.rate2[l]);
        check += t.rate2[l];
    }
    if (w->bodies.centres_valid && how != DEMI_TURN_HALVES) demi_centres_rotate(w, who, count);
    if (!domain) return;
    domain->turn_rate = DEMI_MAX(domain->turn_rate, (double)rate);
    domain->turn = DEMI_MAX(domain->turn, (double)turn);
    domain->turn_speed = DEMI_MAX(domain->turn_speed, (double)speed);
    domain->check += (double)check;
}
/* The same for spheres: q becomes exp(w dt/2) q, with the spin w in the world frame stored in L. */
DEMI_CLONES static void demi_turning_balls(demi_turning *t, int count, dem_real dt) {
    DEMI_ROWS(count)
        const dem_quat now = demi_quat_again(dem_quat_multiply(
            demi_quat_exp(demi_v(t->L[0][q]*dt, t->L[1][q]*dt, t->L[2][q]*dt)),
            dem_quat_make(t->q[0][q], t->q[1][q], t->q[2][q], t->q[3][q])));
        t->q[0][q] = now.w; t->q[1][q] = now.x; t->q[2][q] = now.y; t->q[3][q] = now.z;
    DEMI_ROWS_END
}
/* Rotates the listed spheres, at most a tile. */
static void demi_orient_balls(dem_world *w, const int *who, int count, int how) {
    const dem_real *now = w->bodies.spin, *mean = w->bodies.half_spin;
    const dem_real dt = how == DEMI_TURN_STEP ? w->clock.dt : w->clock.dt/2;
    const int full = (count + DEMI_LANES - 1)/DEMI_LANES*DEMI_LANES;
    demi_turning t;
    int l, e, half;
    for (l = 0; l < full; l++)
        for (e = 0; e < 4; e++) t.q[e][l] = w->bodies.orient[4*who[DEMI_MIN(l, count - 1)] + e];
    for (half = 0; half < (how == DEMI_TURN_HALVES ? 2 : 1); half++) {
        for (l = 0; l < full; l++)
            for (e = 0; e < 3; e++) {
                const int i = 4*who[DEMI_MIN(l, count - 1)] + e;
                t.L[e][l] = how == DEMI_TURN_STEP ? mean[i]
                    : how == DEMI_TURN_HALVES && !half ? 2*mean[i] - now[i] : now[i];
            }
        demi_turning_balls(&t, full, dt);
    }
    for (l = 0; l < count; l++)
        for (e = 0; e < 4; e++) w->bodies.orient[4*(size_t)who[l] + (size_t)e] = t.q[e][l];
}
/* Rotates the listed bodies, at most a tile: spheres if `shaped` is 0, otherwise as
   demi_orient_some. */
static void demi_orient_list(dem_world *w, demi_domain *domain, const int *who, int count, int how,
                             int shaped) {
    if (count && shaped) demi_orient_some(w, domain, who, count, how);
    else if (count) demi_orient_balls(w, who, count, how);
}
/* Advances the orientations of bodies begin .. end - 1, and the spins of those that are not
   spheres, by a step; by half a step, for contact detection, if `domain` is null. */
static void demi_orient_move(dem_world *w, demi_domain *domain, int begin, int end) {
    const int how = !domain ? DEMI_TURN_AHEAD
        : demi_response_is(w, DEMI_MIDWAY) ? DEMI_TURN_HALVES : DEMI_TURN_STEP;
    int who[3][DEMI_TILE], count[3] = {0, 0, 0}, i, k;      /* spheres, round bodies, others */
    for (i = begin; i < end; i++) {
        if (w->bodies.inv_mass[i] <= 0 || (how == DEMI_TURN_AHEAD && !w->bodies.went[i])) continue;
        if (!w->bodies.shape[i] && !w->desc.orientations) continue;
        k = !w->bodies.shape[i] ? 0 : demi_turns_round(w, i) ? 1 : 2;
        who[k][count[k]++] = i;
        if (count[k] < DEMI_TILE) continue;
        demi_orient_list(w, domain, who[k], count[k], how, k);
        count[k] = 0;
    }
    for (k = 0; k < 3; k++) demi_orient_list(w, domain, who[k], count[k], how, k);
}
/* Computes spins at the full step from the angular momentum at the half step and the present
   torque. */
static void demi_orient_finish(dem_world *w, int begin, int end) {
    const dem_real h = (dem_real)w->clock.half_kick;
    int i;
    for (i = begin; i < end; i++)
        if (w->bodies.shape[i] && w->bodies.inv_mass[i] > 0) {
            const dem_vec3 I = demi_at(w->bodies.moment + 4*i);
            demi_put(w->bodies.spin + 4*i, demi_spin_of(demi_quat_at(w->bodies.orient + 4*i),
                demi_add(demi_at(w->bodies.angular + 4*i),
                         demi_scale(demi_at(w->bodies.torque + 4*i), h)),
                demi_v(1/I.x, 1/I.y, 1/I.z)));
        }
}

typedef struct demi_integrator_row {
    const char *name;
    /* a step of bodies begin .. end - 1; turning: 1 if spins are integrated */
    void (*advance)(dem_world *w, int begin, int end, int turning);
    void (*finish)(dem_world *w, int begin, int end);       /* second half kick, if any */
    int order;
    int backward;                  /* 1: needs last_pos, the positions of the last step */
    dem_real back;                 /* how far before the end of a step its half-step velocity
                                      holds, in steps */
    int predicts;                  /* 1: contact laws use velocities that the forces of the step
                                      still change */
} demi_integrator_row;
static const demi_integrator_row demi_integrator_rows[] = {     /* in the order of dem_integrator */
    {"velocity Verlet", demi_move_velocity_verlet, demi_finish_halves, 2, 0, DEM_R(0.5), 1},
    {"forward Euler", demi_move_forward_euler, demi_finish_nothing, 1, 0, 1, 0},
    {"symplectic Euler", demi_move_symplectic_euler, demi_finish_nothing, 1, 0, 0, 0},
    {"position Verlet", demi_move_position_verlet, demi_finish_halves, 2, 1, DEM_R(0.5), 1},
    {"leapfrog", demi_move_leapfrog, demi_finish_halves, 2, 0, DEM_R(0.5), 1},
};
enum { DEMI_INTEGRATORS = (int)(sizeof demi_integrator_rows/sizeof *demi_integrator_rows) };
/* Returns the scheme in force: the midpoint rule with impulses, otherwise that of
   desc.integrator. */
static const demi_integrator_row *demi_integrator_of(const dem_world *w) {
    static const demi_integrator_row midpoint = {"the midpoint rule", demi_move_midpoint,
                                                 demi_finish_nothing, 2, 1, DEM_R(0.5), 0};
    return demi_response_is(w, DEMI_MIDWAY) ? &midpoint
        : demi_integrator_rows + w->desc.integrator;
}

/* Completes the step of one domain's bodies, see demi_finish. */
static void demi_domain_finish(dem_world *w, int d) {
    if (w->bodies.booked) demi_late_note(w, w->domains[d].begin, w->domains[d].end);
    demi_integrator_of(w)->finish(w, w->domains[d].begin, w->domains[d].end);
    if (w->bodies.shaped) demi_orient_finish(w, w->domains[d].begin, w->domains[d].end);
}

/* Performs the second half kick that a step leaves open. Velocities then belong to the present
   time. In the middle of a step (stage.moved) there are no forces for it, and velocities stay as
   predicted. */
static void demi_finish(dem_world *w) {
    if (w->stage.synced || w->stage.moved) return;
    demi_domains_do(w, demi_domain_finish);
    w->stage.synced = 1;
}
/* The same as a task for demi_all. */
static dem_result demi_member_finish(dem_world *w) { demi_finish(w); return DEM_OK; }
