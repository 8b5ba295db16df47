/* ---------------------------------------------------------------------------------------------
   >>belts
   Surfaces that move in themselves, such as belts: the wall stays, or follows its motion, and its
   surface has a velocity of its own. At a contact the surface moves with the part of it across the
   contact normal n: g - n (n.g). This part is continuous where a contact goes round a rim or a
   corner, and 0 where n is along g. A velocity along n would do work against the elastic force
   although the place of the surface, and with it the elastic energy, does not change: that creates
   energy. Owns `glide` and `glides` of walls.
   --------------------------------------------------------------------------------------------- */

/* Returns the velocity of the surface of a wall in this pose at a contact with normal n, m/s,
   without that of the pose. */
DEM_INLINE dem_vec3 demi_glide_at(const demi_wall *wall, const dem_pose *pose, dem_vec3 n) {
    const dem_vec3 g = demi_rotate(pose->rotation, wall->glide);
    return demi_sub(g, demi_scale(n, demi_dot(g, n)));
}
DEM_API dem_result dem_wall_surface_velocity_set(dem_world *w, dem_wall id, dem_vec3 velocity) {
    if (demi_null(w, "dem_wall_surface_velocity_set", w, "world")) return DEM_ERROR_ARGUMENT;
    const int i = demi_wall_find(w, "dem_wall_surface_velocity_set", id);
    demi_wall *wall = i < 0 ? 0 : &w->walls[i];
    if (!wall) return DEM_ERROR_ARGUMENT;
    if (!demi_place(velocity))
        return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_wall_surface_velocity_set: velocity of wall "
                         "%d is (%g, %g, %g) m/s, must be finite and within %g m/s; check how it "
                         "was computed", (int)id.id, (double)velocity.x, (double)velocity.y,
                         (double)velocity.z, DEMI_FARTHEST);
    if (w->desc.planar && fabs((double)velocity.z) > 0)
        return demi_fail(w, DEM_ERROR_ARGUMENT, "dem_wall_surface_velocity_set: velocity of wall "
                         "%d has the z component %g m/s, must be 0 in a planar world, where no "
                         "grain moves along z", (int)id.id, (double)velocity.z);
    wall->glide = demi_unrotate(wall->pose.rotation, velocity);
    wall->glides = demi_dot(velocity, velocity) > 0;
    demi_built(w, "dem_wall_surface_velocity_set");
    w->stage.forces_valid = w->stage.primed = 0;
    if ((double)demi_length(velocity) > w->clock.assumed_speed) demi_dt_outdated(w);
    return DEM_OK;
}
DEM_API dem_result dem_wall_surface_velocity_get(const dem_world *world, dem_wall id,
                                                 dem_vec3 *velocity) {
    const char *call = "dem_wall_surface_velocity_get";
    int i;
    if (demi_null_look(world, call, velocity, "velocity")) return DEM_ERROR_ARGUMENT;
    i = demi_wall_find((dem_world *)world, call, id);
    if (i < 0) return DEM_ERROR_ARGUMENT;
    *velocity = demi_rotate(world->walls[i].pose.rotation, world->walls[i].glide);
    return DEM_OK;
}
