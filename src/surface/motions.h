/* ---------------------------------------------------------------------------------------------
   >>motions
   Motions of walls: the pose at any time, for rotation, oscillation, translation with a ramp, and
   tables of poses. Velocity and spin are the exact derivatives of position and rotation. This part
   reads the motion and the first pose of a wall, and writes poses only.
   --------------------------------------------------------------------------------------------- */
static void demi_pose_identity(dem_pose *p) {
    memset(p, 0, sizeof *p);
    p->rotation[0] = p->rotation[4] = p->rotation[8] = 1;
}

/* Distance travelled after t >= 0 at a speed that rises smoothly for `ramp` s, expressed as the
   time at full speed that it equals, s. *part: present speed over full speed. */
static double demi_ramp(double t, double ramp, double *part) {
    const double u = ramp > 0 && t < ramp ? t/ramp : 1;
    *part = u*u*(3 - 2*u);
    return u < 1 ? ramp*u*u*u*(1 - u/2) : t - ramp/2;
}
/* Rotates a wall by `turn` (3 x 3) from the pose in which its motion started, into pose->rotation.
   Returns the vector from the point of its motion to its origin then, m. */
static dem_vec3 demi_pose_turn(const demi_wall *wall, const double *turn, dem_pose *pose) {
    dem_real T[9];
    int i, j;
    for (i = 0; i < 9; i++) T[i] = (dem_real)turn[i];
    for (i = 0; i < 3; i++)
        for (j = 0; j < 3; j++)
            pose->rotation[3*i + j] = (dem_real)(turn[3*i]*(double)wall->home.rotation[j] +
                turn[3*i + 1]*(double)wall->home.rotation[3 + j] +
                turn[3*i + 2]*(double)wall->home.rotation[6 + j]);
    return demi_rotate(T, demi_sub(wall->home.position, wall->motion.point));
}
/* Number c of row k of a table (0..2: position, 3..6: rotation). */
static double demi_row_number(const dem_motion *m, int k, int c) {
    const dem_motion_row *r = m->table + k;
    switch (c) {
    case 0: return (double)r->position.x;
    case 1: return (double)r->position.y;
    case 2: return (double)r->position.z;
    case 3: return (double)r->rotation.w;
    case 4: return (double)r->rotation.x;
    case 5: return (double)r->rotation.y;
    default: return (double)r->rotation.z;
    }
}
/* Derivative of number c at row k, per second: that of the parabola through the row and its
   neighbours, across the ends of a table that repeats; 0 at the ends of one that does not. */
static double demi_row_slope(const dem_motion *m, int k, int c) {
    const int last = m->table_count - 1, ends = k == 0 || k == last;
    const int before = k == 0 ? last - 1 : k - 1, after = k == last ? 1 : k + 1;
    const int here_a = k == 0 ? last : k, here_b = k == last ? 0 : k;   /* the same pose */
    int i;
    double a, b, ta, tb, side = 0;
    if (ends && !m->table_repeats) return 0;
    /* q and -q are the same rotation: the last row may have the other sign */
    for (i = 3; ends && c > 2 && i < 7; i++)
        side += demi_row_number(m, 0, i)*demi_row_number(m, last, i);
    ta = m->table[here_a].time - m->table[before].time;
    tb = m->table[after].time - m->table[here_b].time;
    a = (demi_row_number(m, here_a, c) - demi_row_number(m, before, c))/ta;
    b = (demi_row_number(m, after, c) - demi_row_number(m, here_b, c))/tb;
    if (side < 0) *(k == 0 ? &a : &b) *= -1;
    return (a*tb + b*ta)/(ta + tb);
}
/* Cubic Hermite interpolation between two rows. Quaternions are interpolated likewise and then
   normalised; the spin is the exact derivative of the normalised quaternion. */
static void demi_table_pose(const demi_wall *wall, double t, dem_pose *pose) {
    const dem_motion *m = &wall->motion;
    const int last = m->table_count - 1;
    const double end = m->table[last].time;
    const int early = t < 0;       /* a table that repeats has a slope at its first row */
    double x[7], v[7], size = 0, along = 0, h, u, R[9], w[3];
    dem_vec3 arm, at;
    int k = 0, c;
    if (m->table_repeats && t > 0) t = fmod(t, end);
    t = DEMI_MIN(DEMI_MAX(t, 0), end);
    while (k + 1 < last && t >= m->table[k + 1].time) k++;
    h = m->table[k + 1].time - m->table[k].time;
    u = (t - m->table[k].time)/h;
    for (c = 0; c < 7; c++) {
        const double a = demi_row_number(m, k, c), b = demi_row_number(m, k + 1, c);
        const double p = h*demi_row_slope(m, k, c), q = h*demi_row_slope(m, k + 1, c);
        x[c] = a + u*(p + u*(3*(b - a) - 2*p - q + u*(2*(a - b) + p + q)));
        v[c] = early ? 0 : (p + u*(2*(3*(b - a) - 2*p - q) + u*3*(2*(a - b) + p + q)))/h;
    }
    for (c = 3; c < 7; c++) size += x[c]*x[c];
    size = sqrt(size);
    for (c = 3; c < 7; c++) { x[c] /= size; v[c] /= size; along += x[c]*v[c]; }
    for (c = 3; c < 7; c++) v[c] -= along*x[c];
    /* w = 2 dq/dt q* */
    w[0] = 2*(-v[3]*x[4] + v[4]*x[3] - v[5]*x[6] + v[6]*x[5]);
    w[1] = 2*(-v[3]*x[5] + v[4]*x[6] + v[5]*x[3] - v[6]*x[4]);
    w[2] = 2*(-v[3]*x[6] - v[4]*x[5] + v[5]*x[4] + v[6]*x[3]);
    R[0] = 1 - 2*(x[5]*x[5] + x[6]*x[6]); R[1] = 2*(x[4]*x[5] - x[3]*x[6]);
    R[2] = 2*(x[4]*x[6] + x[3]*x[5]);     R[3] = 2*(x[4]*x[5] + x[3]*x[6]);
    R[4] = 1 - 2*(x[4]*x[4] + x[6]*x[6]); R[5] = 2*(x[5]*x[6] - x[3]*x[4]);
    R[6] = 2*(x[4]*x[6] - x[3]*x[5]);     R[7] = 2*(x[5]*x[6] + x[3]*x[4]);
    R[8] = 1 - 2*(x[4]*x[4] + x[5]*x[5]);
    arm = demi_pose_turn(wall, R, pose);
    at = demi_v((dem_real)x[0], (dem_real)x[1], (dem_real)x[2]);
    pose->position = demi_add(demi_add(m->point, at), arm);
    pose->spin = demi_v((dem_real)w[0], (dem_real)w[1], (dem_real)w[2]);
    pose->velocity = demi_add(demi_v((dem_real)v[0], (dem_real)v[1], (dem_real)v[2]),
                              demi_cross(pose->spin, arm));
}
/* True if a motion follows a table. */
static int demi_tabled(const dem_motion *m) {
    return m->kind == DEM_MOTION_TABLE ||
        (m->kind == DEM_MOTION_SERVO && (m->table || m->table_count));
}
/* Returns the load of a servo wall at a time, N: that of its desc or of its table, as it rises over
   the ramp. */
static double demi_servo_target(const dem_motion *m, double time) {
    double t = time - m->start, part, load = (double)m->load;
    int k = 0;
    demi_ramp(t, m->ramp, &part);
    if (demi_tabled(m)) {
        const dem_motion_row *r = m->table;
        const double end = r[m->table_count - 1].time;
        t = DEMI_MAX(0, m->table_repeats ? fmod(t, end) : DEMI_MIN(t, end));
        while (k + 2 < m->table_count && t >= r[k + 1].time) k++;
        load = (double)r[k].load + ((double)r[k + 1].load - (double)r[k].load)*
            (t - r[k].time)/(r[k + 1].time - r[k].time);
    }
    return load*part*(m->area > 0 ? (double)m->area : 1);
}
/* Copies the table of a motion for a wall. Quaternions are normalised, and each has the sign nearer
   to the one before. Returns 0 if memory ran out. */
static int demi_table_make(dem_world *w, const dem_motion *m, dem_motion_row **out) {
    dem_motion_row *rows;
    int k;
    *out = 0;
    if (!demi_tabled(m)) return 1;
    rows = (dem_motion_row *)demi_hold(w, DEMI_SCENE, (size_t)m->table_count, sizeof *rows);
    if (!rows) return 0;
    for (k = 0; k < m->table_count; k++) {
        dem_quat q = m->table[k].rotation;
        rows[k] = m->table[k];
        if (!(demi_quat_most(q) > 0)) q = dem_quat_make(1, 0, 0, 0);
        q = demi_quat_unit(q);
        if (k && q.w*rows[k - 1].rotation.w + q.x*rows[k - 1].rotation.x +
            q.y*rows[k - 1].rotation.y + q.z*rows[k - 1].rotation.z < 0)
            q = dem_quat_make(-q.w, -q.x, -q.y, -q.z);
        rows[k].rotation = q;
    }
    *out = rows;
    return 1;
}
/* Checks the table of a motion, on behalf of dem_wall_motion_set. */
static dem_result demi_table_check(dem_world *w, int wall, const dem_motion *m) {
    int k, bad = -1;
    if (!m->table || m->table_count < 2)
        return demi_refuse(w, "dem_wall_motion_set", "the table of wall %d has %d rows, must have "
                           "at least 2; set table and table_count", wall,
                           m->table ? m->table_count : 0);
    for (k = 0; k < m->table_count && bad < 0; k++) {
        const dem_motion_row *r = m->table + k;
        if (!demi_finite_double(r->time) || !demi_place(r->position) ||
            !demi_quat_finite(r->rotation) || !demi_finite(r->load) ||
            (k ? !(r->time > r[-1].time) : r->time < 0 || r->time > 0)) bad = k;
    }
    if (bad < 0) return DEM_OK;
    return demi_refuse(w, "dem_wall_motion_set", "row %d of the table of wall %d, at %g s, is not "
                       "finite or not later than the row before; the first row must be at 0 s", bad,
                       wall, m->table[bad].time);
}
/* Sets the pose of a wall at a time. Rotations start from the first pose each time, so no error
   builds up. Velocities are exact derivatives. */
static void demi_wall_pose_at(const dem_world *world, const demi_wall *wall, double time,
                              dem_pose *pose) {
    const dem_motion *m = &wall->motion;
    const double t = time - m->start;
    double gone, part;
    *pose = wall->home;
    pose->velocity = pose->spin = demi_v(0, 0, 0);
    switch (m->kind) {
    case DEM_MOTION_FIXED: break;
    case DEM_MOTION_TRANSLATING:
        if (t < 0) break;
        gone = demi_ramp(t, m->ramp, &part);
        pose->position = demi_add(pose->position, demi_scale(m->velocity, (dem_real)gone));
        pose->velocity = demi_scale(m->velocity, (dem_real)part);
        break;
    case DEM_MOTION_ROTATING: {
        const dem_vec3 axis = demi_unit(m->axis);
        double turn[9];
        if (t < 0 || !(DEMI_ABS(m->speed) > 0)) break;
        gone = demi_ramp(t, m->ramp, &part);
        demi_rotation(turn, (double)axis.x, (double)axis.y, (double)axis.z,
                      fmod((double)m->speed*gone, 2*DEMI_PI));
        pose->position = demi_add(m->point, demi_pose_turn(wall, turn, pose));
        pose->spin = demi_scale(axis, m->speed*(dem_real)part);
        pose->velocity = demi_cross(pose->spin, demi_sub(pose->position, m->point));
        break;
    }
    case DEM_MOTION_OSCILLATING: {
        const dem_vec3 way = demi_unit(m->velocity);
        const double w = 2*DEMI_PI*(double)m->frequency, phase = w*t + (double)m->phase;
        const double u = m->ramp > 0 && t < m->ramp ? t/m->ramp : 1;
        const double grows = u < 1 ? 6*u*(1 - u)/m->ramp : 0;
        if (t < 0) break;
        part = u*u*(3 - 2*u);
        pose->position = demi_add(pose->position, demi_scale(way, (dem_real)(
            part*(double)m->amplitude*demi_sin(phase))));
        pose->velocity = demi_scale(way, (dem_real)((double)m->amplitude*
            (part*w*demi_cos(phase) + grows*demi_sin(phase))));
        break;
    }
    case DEM_MOTION_USER:
        DEMI_USER(world, "the motion of walls", 1, m->function(time, pose, m->user))
        break;
    case DEM_MOTION_TABLE: demi_table_pose(wall, t, pose); break;
    case DEM_MOTION_SERVO:
        pose->velocity = demi_scale(demi_unit(m->velocity), (dem_real)wall->servo.speed);
        pose->position = demi_add(pose->position, demi_scale(demi_unit(m->velocity), (dem_real)(
            wall->servo.travel + wall->servo.speed*(time - wall->servo.time))));
        break;
    }
}

/* True if the numbers of a pose are finite and in range, and its matrix may be a rotation. */
static int demi_pose_sane(const dem_pose *p) {
    int i, ok = demi_place(p->position) && demi_place(p->velocity) && demi_place(p->spin);
    for (i = 0; i < 9; i++)
        ok = ok && demi_finite(p->rotation[i]) && DEMI_ABS(p->rotation[i]) <= 2;
    return ok;
}
/* Numbers of a motion, in the order in which a checkpoint has them, then what is not a number. */
#define DEMI_MOVED(field, type, how, unit) \
    DEMI_LIMITED(dem_motion, field, type, how, DEMI_FARTHEST, unit)
static const demi_field_row demi_motion_rows[] = {
    DEMI_ROW_ENUM(dem_motion, kind, DEMI_FROM, 0,
                  "fixed translating rotating oscillating user table servo"),
    DEMI_MOVED(velocity, 'v', DEMI_ANY, "m/s"), DEMI_MOVED(point, 'v', DEMI_ANY, "m"),
    DEMI_MOVED(axis, 'v', DEMI_ANY, ""), DEMI_MOVED(speed, 'r', DEMI_ANY, "rad/s"),
    DEMI_MOVED(amplitude, 'r', DEMI_ANY, "m"), DEMI_MOVED(frequency, 'r', DEMI_ANY, "Hz"),
    DEMI_MOVED(phase, 'r', DEMI_ANY, "rad"), DEMI_MOVED(start, 'd', DEMI_ANY, "s"),
    DEMI_MOVED(ramp, 'd', DEMI_FROM, "s"), DEMI_MOVED(load, 'r', DEMI_ANY, "N"),
    DEMI_MOVED(area, 'r', DEMI_FROM, "m2"), DEMI_MOVED(travel, 'r', DEMI_FROM, "m"),
    DEMI_ROW_FREE(dem_motion, function),
    DEMI_ROW_FREE(dem_motion, user), DEMI_ROW_FREE(dem_motion, table),
    DEMI_ROW(dem_motion, table_count, 'i'), DEMI_ROW(dem_motion, table_repeats, 'i'),
    DEMI_ROW_END};

#define DEMI_SERVED(field, how) DEMI_LIMITED(dem_servo, field, 'd', how, DBL_MAX, "")
static const demi_field_row demi_servo_rows[] = {
    DEMI_SERVED(target, DEMI_ANY), DEMI_SERVED(force, DEMI_ANY), DEMI_SERVED(speed, DEMI_ANY),
    DEMI_SERVED(travel, DEMI_ANY), DEMI_SERVED(stiffness, DEMI_ANY),
    DEMI_SERVED(damping, DEMI_ANY), DEMI_SERVED(time, DEMI_ANY), DEMI_ROW_END};

/* Upper bound of the speed, m/s, of all points of a wall in a pose. For vertices two bounds hold,
   and the lower one counts: the speed of the frame's origin plus spin times the extent, and the
   largest speed of a corner of their box, since the speed is a convex function of the point. */
static double demi_pose_pace(const demi_wall *wall, const dem_pose *p) {
    const double far = (double)DEMI_MAX(wall->extent, wall->radius);
    const double pace = (double)demi_length(p->velocity) + (double)demi_length(p->spin)*far;
    double corner = 0;
    int i;
    for (i = 0; i < 8 && wall->vertex_count; i++) {
        const dem_vec3 x = demi_v(i & 1 ? wall->box.hi.x : wall->box.lo.x,
                                  i & 2 ? wall->box.hi.y : wall->box.lo.y,
                                  i & 4 ? wall->box.hi.z : wall->box.lo.z);
        corner = DEMI_MAX(corner, (double)demi_length(demi_add(p->velocity,
            demi_cross(p->spin, demi_rotate(p->rotation, x)))));
    }
    return wall->vertex_count ? DEMI_MIN(pace, corner) : pace;
}
/* Upper bound of the speed of a wall's surface, m/s; 0 if its motion leaves the surface in place;
   -1 if there is no bound. */
static double demi_wall_speed(const demi_wall *wall) {
    const dem_pose *p = &wall->pose;
    if (wall->kind == DEMI_WALL_NONE || wall->symmetric) return 0;
    if (wall->extent < 0 && demi_length(p->spin) > 0) return -1;   /* infinite: search every step */
    return wall->extent < 0 ? (double)demi_length(p->velocity) : demi_pose_pace(wall, p);
}
/* Surfaces that move in themselves, such as belts: the wall stays, or follows its motion, and its
   surface has a velocity of its own. At a contact the surface moves with the part of it across the
   contact normal n: g - n (n.g). This part is continuous where a contact goes round a rim or a
   corner, and 0 where n is along g. A velocity along n would do work against the elastic force
   although the place of the surface, and with it the elastic energy, does not change: that creates
   energy. `glide` and `glides` of walls hold the velocity; >>steering sets them. */
/* Returns the velocity of the surface of a wall in this pose at a contact with normal n, m/s,
   without that of the pose. */
DEM_INLINE dem_vec3 demi_glide_at(const demi_wall *wall, const dem_pose *pose, dem_vec3 n) {
    const dem_vec3 g = demi_rotate(pose->rotation, wall->glide);
    return demi_sub(g, demi_scale(n, demi_dot(g, n)));
}
/* Returns the largest speed of a wall during its motion, m/s, also before the motion has begun. For
   a user-defined motion: its present speed. A table is sampled eight times per row. */
static double demi_pose_speed(const demi_wall *wall) {
    const dem_motion *m = &wall->motion;
    dem_pose p = wall->pose;
    switch (m->kind) {
    case DEM_MOTION_FIXED: return 0;
    case DEM_MOTION_TRANSLATING: case DEM_MOTION_SERVO: return (double)demi_length(m->velocity);
    case DEM_MOTION_ROTATING:
        p.spin = demi_scale(demi_unit(m->axis), m->speed);
        p.velocity = demi_cross(p.spin, demi_sub(p.position, m->point));
        return demi_pose_pace(wall, &p);
    case DEM_MOTION_OSCILLATING:
        return (2*DEMI_PI*fabs((double)m->frequency) + (m->ramp > 0 ? 1.5/m->ramp : 0))*
               fabs((double)m->amplitude);
    case DEM_MOTION_TABLE: {
        const double end = m->table[m->table_count - 1].time;
        const int looks = 8*m->table_count;
        double most = 0;
        int k;
        for (k = 0; k <= looks; k++) {
            demi_wall_pose_at(0, wall, m->start + end*k/looks, &p);
            most = DEMI_MAX(most, demi_pose_pace(wall, &p));
        }
        return most;
    }
    default: break;
    }
    return demi_pose_pace(wall, &p);
}
