/* ---------------------------------------------------------------------------------------------
   >>belts
   Surfaces that move in themselves, such as belts: the wall stays, or follows its motion, and its
   surface has a velocity of its own. At a contact the surface moves with the part of it across the
   contact normal n: g - n (n.g). This part is continuous where a contact goes round a rim or a
   corner, and 0 where n is along g. A velocity along n would do work against the elastic force
   although the place of the surface, and with it the elastic energy, does not change: that creates
   energy. `glide` and `glides` of walls hold the velocity; >>steering sets them.
   --------------------------------------------------------------------------------------------- */

/* Returns the velocity of the surface of a wall in this pose at a contact with normal n, m/s,
   without that of the pose. */
DEM_INLINE dem_vec3 demi_glide_at(const demi_wall *wall, const dem_pose *pose, dem_vec3 n) {
    const dem_vec3 g = demi_rotate(pose->rotation, wall->glide);
    return demi_sub(g, demi_scale(n, demi_dot(g, n)));
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
