/* ---------------------------------------------------------------------------------------------
   >>steering
   New motions of walls, and new velocities of belts, during a run. After most changes of the scene
   the next step computes all forces again, from the velocities of the full step. A program that
   leads a wall sets its motion at every step, or every few steps. To make this cheap, only forces
   of contacts with this wall are computed again: those with the old velocity are subtracted from
   the forces on grains, those with the new velocity are added. Sums thus differ by rounding. This
   part writes the motions and surface velocities (`glide`, `glides`) of walls, and the forces and
   half-step velocities of grains that touch such a wall.
   --------------------------------------------------------------------------------------------- */

/* A program leads a wall if at most this number of steps lie between two motions: eight, and half a
   step for rounding errors of times. */
#define DEMI_LED 8.5

/* Evaluates a tile of contacts with a wall, adds `sign` times their forces to those of the grains,
   and updates the half-step velocities of these grains. Contact histories do not change. Empties
   the tile. */
static void demi_steer_tile(dem_world *w, demi_points *t, dem_real sign) {
    int q;
    demi_persistent_evaluate(w, t);
    for (q = 0; q < t->count; q++) {
        demi_persistent *c = t->contact[q];
        dem_vec3 force, torque;
        c->force = demi_point_own(t, q, &torque);
        force = demi_row(t->rows.force, q);
        torque = demi_row(t->rows.torque[0], q);
        if (w->desc.planar) force.z = torque.x = torque.y = 0;
        demi_force_add(w->bodies.force + 4*c->a, demi_scale(force, sign));
        demi_force_add(w->bodies.torque + 4*c->a, demi_scale(torque, sign));
        if (w->stage.primed) demi_prime_body(w, c->a);
    }
    t->count = t->turns = t->weighted = t->lifted = 0;
}
/* Adds `sign` times the forces of all contacts with a wall to those of the grains. */
static void demi_steer(dem_world *w, int wall, dem_real sign) {
    DEMI_ALIGNED demi_points tile;
    int d, k, known;
    demi_persistent_tile_begin(w, &tile, 0, DEMI_TILE);
    for (d = 0; d < w->domain_count; d++) {
        known = demi_persistent_rows_begin(w, d, w->domains[d].persistent);
        for (k = 0; k < w->domains[d].persistent; k++) {
            demi_persistent *c = demi_persistent_of(w, d) + k;
            if (c->b >= 0 || c->wall != wall || !demi_persistent_asked(w, c)) continue;
            if (w->bodies.shaped) demi_yields_turn(w, c->a, c->a + 1);
            demi_persistent_add(&tile, c, c, c->memory, demi_persistent_row(w, d, c, c, known));
            if (tile.count == DEMI_TILE) demi_steer_tile(w, &tile, sign);
        }
        if (tile.count) demi_steer_tile(w, &tile, sign);
        if (!known) w->domains[d].coefs = 0;    /* other contacts have no row yet */
    }
}
/* Call this before the velocity of a wall's surface changes, and demi_wall_after after it. If the
   forces are valid, the first call subtracts those of the wall's contacts and the second adds them
   with the new velocity. Otherwise the next step computes all forces again. So it does with
   impulses, with rails (their reactions depend on these forces) and with laws that exchange
   user-defined numbers. */
static void demi_wall_before(dem_world *w, int wall) {
    demi_finish(w);                             /* the open half kick belongs to the old forces */
    if (!demi_response_is(w, DEMI_LASTING) || w->rail_count || demi_exchanges(w) ||
        !w->stage.list_valid || w->stage.pairs_changed || w->stage.moved || !w->stage.forces_valid)
        demi_forces_outdated(w);
    else demi_steer(w, wall, -1);
}
/* Call this after the velocity of a wall's surface has changed: see demi_wall_before. */
static void demi_wall_after(dem_world *w, int wall) {
    if (w->stage.forces_valid) demi_steer(w, wall, 1);
}

DEM_API dem_result dem_wall_surface_velocity_get(const dem_world *world, dem_wall id,
                                                 dem_vec3 *velocity) {
    int i;
    if (demi_null_look(world, __func__, velocity, "velocity")) return DEM_ERROR_ARGUMENT;
    i = demi_wall_find((dem_world *)world, __func__, id);
    if (i < 0) return DEM_ERROR_ARGUMENT;
    *velocity = demi_rotate(world->walls[i].pose.rotation, world->walls[i].glide);
    return DEM_OK;
}
DEM_API dem_result dem_wall_surface_velocity_set(dem_world *w, dem_wall id, dem_vec3 velocity) {
    if (demi_null(w, __func__, w, "world")) return DEM_ERROR_ARGUMENT;
    const int i = demi_wall_find(w, __func__, id);
    demi_wall *wall = i < 0 ? 0 : &w->walls[i];
    if (!wall) return DEM_ERROR_ARGUMENT;
    if (!demi_place(velocity))
        return demi_refuse(w, __func__, "velocity of wall %d is (%g, %g, "
                           "%g) m/s, must be finite and within %g m/s; check how it was computed",
                           (int)id.id, (double)velocity.x, (double)velocity.y, (double)velocity.z,
                           DEMI_FARTHEST);
    if (w->desc.planar && fabs((double)velocity.z) > 0)
        return demi_refuse(w, __func__, "velocity of wall %d has the z "
                           "component %g m/s, must be 0 in a planar world, where no grain moves "
                           "along z", (int)id.id, (double)velocity.z);
    demi_wall_before(w, i);
    wall->glide = demi_unrotate(wall->pose.rotation, velocity);
    wall->glides = demi_dot(velocity, velocity) > 0;
    demi_wall_after(w, i);
    demi_built(w, __func__);
    if ((double)demi_length(velocity) > w->clock.assumed_speed) demi_dt_outdated(w);
    return DEM_OK;
}

DEM_API dem_result dem_wall_pose_get(const dem_world *world, dem_wall id, dem_pose *pose) {
    if (demi_null_look(world, __func__, pose, "pose")) return DEM_ERROR_ARGUMENT;
    const int i = demi_wall_find((dem_world *)world, __func__, id);
    if (i < 0) return DEM_ERROR_ARGUMENT;
    *pose = world->walls[i].pose;
    return DEM_OK;
}
/* True if the time step stays right for a wall with a new motion: the wall is not faster than the
   impacts for which the step was chosen, and moves by less than a tenth of the smallest radius in a
   step. */
static int demi_motion_slow(const dem_world *w, const demi_wall *wall) {
    const double v = demi_pose_speed(wall);
    return 10*v*(double)w->clock.dt < (double)w->effects.radius_min &&
        (!(v > 0) || w->desc.dt > 0 || v <= w->clock.assumed_speed);
}
/* True if a wall stays where it is when its new motion `to` begins. A rotation may start there with
   rounding errors. A motion with a phase, by a table or by a function may begin elsewhere. */
static int demi_wall_stays(const demi_wall *from, const demi_wall *to) {
    return to->motion.kind == DEM_MOTION_ROTATING ||
        (!memcmp(&from->pose.position, &to->pose.position, sizeof to->pose.position) &&
         !memcmp(from->pose.rotation, to->pose.rotation, sizeof to->pose.rotation));
}
/* True if a program leads a wall that stays: its old motion began at most DEMI_LED steps ago, or
   has yet to begin. */
static int demi_wall_led(const dem_world *w, const demi_wall *from) {
    return w->clock.time - from->motion.start <= DEMI_LED*(double)w->clock.dt;
}
DEM_API dem_result dem_wall_motion_set(dem_world *w, dem_wall id, const dem_motion *motion) {
    if (demi_null(w, __func__, motion, "motion")) return DEM_ERROR_ARGUMENT;
    const int i = demi_wall_find(w, __func__, id);
    demi_wall next;
    const void *rows;
    void *old;
    int dropped, remains;
    dem_result result;
    if (i < 0) return DEM_ERROR_ARGUMENT;
    result = demi_motion_lay(w, id, motion, &w->walls[i], &next);
    if (result != DEM_OK) return result;
    /* from its present pose on, a wall that moves alone has the same candidates, if no rotation
       decides which of its periodic images are at rest relative to it */
    remains = demi_wall_stays(&w->walls[i], &next) && demi_wall_remains(w, &next, i) &&
        (!w->repeating || (!demi_motion_turns(&w->walls[i].motion) &&
                           !demi_motion_turns(&next.motion)));
    dropped = remains || demi_list_drop(w);
    rows = dropped ? w->walls[i].motion.table : next.motion.table;
    memcpy(&old, &rows, sizeof old);
    if (demi_owns(w, DEMI_SCENE, old)) demi_free(w, old);
    if (!dropped) return demi_no_memory(w, __func__);
    if (!remains) demi_surfaces_outdated(w);
    if (!remains || !demi_wall_led(w, &w->walls[i])) demi_forces_outdated(w);
    demi_wall_before(w, i);
    w->walls[i] = next;
    demi_wall_after(w, i);
    demi_built(w, __func__);
    if (!remains || !demi_motion_slow(w, &next)) demi_dt_outdated(w);
    return demi_rails_lead(w, i) ? DEM_OK : demi_no_memory(w, __func__);
}
