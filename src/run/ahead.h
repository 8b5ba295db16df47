/* ---------------------------------------------------------------------------------------------
   >>ahead
   Half a step ahead, where impulses act: bodies and walls are moved there for the detection of
   contacts, and back. Writes positions, orientations and spins of bodies, and poses of walls.
   --------------------------------------------------------------------------------------------- */
/* Contacts are detected half a step ahead, where the present velocities carry the bodies. Impulses
   and force fields act there, so that a step is symmetric in time and of second order. */
enum { DEMI_AHEAD = 1024 };                     /* bodies that a thread takes at a time */
/* Moves run `index` of the bodies half a step ahead; last_pos and last_orient keep the present
   positions and orientations. */
static void demi_some_ahead(dem_world *w, int index) {
    const int begin = index*DEMI_AHEAD, end = DEMI_MIN(begin + DEMI_AHEAD, w->bodies.count);
    const dem_real h = w->clock.dt/2;
    const size_t first = 4*(size_t)begin, size = 4*(size_t)(end - begin)*sizeof(dem_real);
    int i, k;
    memcpy(w->bodies.last_pos + first, w->bodies.pos + first, size);
    for (i = begin; i < end; i++)
        for (k = 4*i; k < 4*i + 3 && w->bodies.went[i]; k++)
            w->bodies.pos[k] += w->bodies.vel[k]*h;
    if (!w->bodies.orienting) return;
    memcpy(w->bodies.last_orient + first, w->bodies.orient + first, size);
    demi_orient_move(w, 0, begin, end);
}
/* Moves them back, and restores their spins. */
static void demi_some_back(dem_world *w, int index) {
    const int begin = index*DEMI_AHEAD, end = DEMI_MIN(begin + DEMI_AHEAD, w->bodies.count);
    const size_t first = 4*(size_t)begin, size = 4*(size_t)(end - begin)*sizeof(dem_real);
    int i;
    memcpy(w->bodies.pos + first, w->bodies.last_pos + first, size);
    if (!w->bodies.orienting) return;
    memcpy(w->bodies.orient + first, w->bodies.last_orient + first, size);
    for (i = begin; i < end; i++) {
        const dem_vec3 I = demi_at(w->bodies.moment + 4*i);
        if (!w->bodies.shape[i] || !(w->bodies.inv_mass[i] > 0)) continue;
        demi_put(w->bodies.spin + 4*i, demi_spin_of(demi_quat_at(w->bodies.orient + 4*i),
            demi_at(w->bodies.angular + 4*i), demi_v(1/I.x, 1/I.y, 1/I.z)));
        if (w->bodies.centres_valid) demi_centres_rotate(w, &i, 1);
    }
}
/* Moves bodies and walls half a step ahead. wall->mid keeps the present pose of a wall. wall->ahead
   is its pose a whole step ahead, midway between two detections; surface velocities are those of
   that time, and so is the speed of the fastest wall. Bodies that were just set are not ahead
   (demi_move_midpoint). */
static void demi_ahead(dem_world *w) {
    const double dt = (double)w->clock.dt;
    const int runs = (w->bodies.count + DEMI_AHEAD - 1)/DEMI_AHEAD;
    int i;
    demi_parallel(w, w->threads.now, runs, 0, demi_some_ahead);
    w->margin.walls_pace = 0;
    for (i = 0; i < w->wall_count; i++) {
        demi_wall *wall = &w->walls[i];
        dem_pose half, pose;
        double pace;
        wall->mid = wall->ahead = wall->pose;
        if (wall->kind == DEMI_WALL_NONE || wall->motion.kind == DEM_MOTION_FIXED) continue;
        demi_wall_pose_at(w, wall, w->clock.time + dt/2, &half);
        demi_wall_pose_at(w, wall, w->clock.time + dt, &pose);
        if (demi_pose_sane(&pose)) wall->pose = wall->ahead = pose;
        pace = demi_wall_pace(w, i);
        w->margin.walls_pace = pace < 0 ? 1e300 : DEMI_MAX(w->margin.walls_pace, pace);
        wall->pose = demi_pose_sane(&half) ? half : wall->mid;
    }
}
/* Moves bodies and walls back to the positions before demi_ahead. */
static void demi_ahead_back(dem_world *w) {
    const int runs = (w->bodies.count + DEMI_AHEAD - 1)/DEMI_AHEAD;
    int i;
    demi_parallel(w, w->threads.now, runs, 0, demi_some_back);
    for (i = 0; i < w->wall_count; i++) w->walls[i].pose = w->walls[i].mid;
}
