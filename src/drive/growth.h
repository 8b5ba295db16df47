/* ---------------------------------------------------------------------------------------------
   >>growth
   Bodies that change their size while a world runs: dem_body_radius_set, and desc.growth. All
   lengths of a body scale with its radius; mass and moments of inertia follow from the density of
   its material. Its velocity, spin and contact histories stay. New lists are built, so everything
   that depends on radii or masses follows: coefficients, reach, skin, tessellations, time step.
   The ledger. The kinetic energy that new mass has, or that lost mass takes along, counts as
   inserted. The energy that springs gain or lose because radii change is `growth`, as with every
   change of the scene: forces are computed twice at the same positions, before and after, and the
   ledger takes the difference. It is the work of the force on the surface that grows.
   Owns clock.grown and w->grown.
   --------------------------------------------------------------------------------------------- */

/* As demi_mass_bad, for body i with this radius, m. */
static int demi_size_bad(const dem_world *w, int i, dem_real radius, double *mass) {
    const demi_shape *shape = demi_shape_of(w, i);
    return demi_mass_bad(w, w->bodies.material[i] - 1, shape ? w->bodies.shape[i] - 1 : -1,
                         shape ? radius/shape->radius : radius, mass);
}
/* Gives body i another radius, m, and mass, kg. The list must have been dropped. */
static void demi_body_resize(dem_world *w, int i, dem_real radius, double mass) {
    const demi_shape *shape = demi_shape_of(w, i);
    const int fixed = w->bodies.inv_mass[i] <= 0;
    const double before = demi_body_energy(w, i);
    w->bodies.pos[4*i + 3] = radius;
    w->bodies.mass[i] = (dem_real)mass;
    w->bodies.inv_mass[i] = fixed ? 0 : (dem_real)(1/mass);
    w->bodies.inv_inertia[i] = fixed || shape ? 0
        : (dem_real)(1/demi_sphere_inertia(w, mass, (double)radius));
    if (w->bodies.orienting) {
        demi_put(w->bodies.moment + 4*i, demi_moments_of(w, i));
        if (shape) w->bodies.moment[4*i + 3] = shape->moment_arm*demi_scale_of(w, i, shape);
        demi_put(w->bodies.angular + 4*i, demi_angular_of(w, i));
    }
    w->booked.inserted += demi_body_energy(w, i) - before;
}
DEM_API dem_result dem_body_radius_set(dem_world *w, dem_body body, dem_real radius) {
    if (demi_null(w, __func__, w, "world")) return DEM_ERROR_ARGUMENT;
    const int i = demi_body_index(w, __func__, body);
    double mass;
    if (i < 0) return DEM_ERROR_ARGUMENT;
    if (demi_size_bad(w, i, radius, &mass))
        return demi_refuse(w, __func__, "the radius of body %u is %g m and its mass %g kg, must be "
                           "> 0 and neither too small nor too large to calculate with in %s "
                           "precision; lengths are in metres: check the unit", (unsigned)body.slot,
                           (double)radius, mass, DEMI_SINGLE ? "single" : "double");
    demi_finish(w);                             /* the open half kick belongs to the old mass */
    if (!demi_list_drop(w)) return demi_no_memory(w, __func__);
    demi_body_resize(w, i, radius, mass);
    demi_scene_changed(w);
    return DEM_OK;
}

/* Asks desc.growth for the rates of all bodies and applies them up to the end of the coming step.
   Radii change after all rates are known, so that no rate depends on the order of bodies.
   w->grown receives 1 if a radius has changed, 3 if one has become smaller. */
static dem_result demi_member_grow(dem_world *w) {
    const double passed = w->clock.time + (double)w->clock.dt - w->clock.grown;
    const int n = w->bodies.count;
    dem_real *radius = (dem_real *)demi_alloc(w, (size_t)n + 1, sizeof *radius);
    dem_result result = radius ? DEM_OK : demi_no_memory(w, "dem_world_step");
    double mass = 0;
    int i, grown = 0;
    demi_finish(w);                             /* the function receives complete velocities, */
    for (i = 0; i < n && result == DEM_OK; i++) {   /* and the open half kick the old masses */
        const dem_body id = dem_body_id_get(w, i);
        const dem_real r = radius[i] = demi_radius(w, i);
        dem_body_state state;
        dem_real rate;
        if (demi_is_ghost(w, i) || dem_body_get(w, id, &state) != DEM_OK) continue;
        DEMI_USER(w, "a step", 1,
                  rate = w->desc.growth(&state, id, w->clock.time, w->desc.growth_user))
        radius[i] = r + (dem_real)((double)rate*passed);
        if (rate < 0 || rate > 0 || !demi_finite(rate)) grown |= rate < 0 ? 3 : 1;
        if (demi_size_bad(w, i, radius[i], &mass))
            result = demi_fail(w, DEM_ERROR_UNSTABLE, "dem_world_step: step %llu: body %u grows "
                               "from %g m to %g m at %g m/s (desc.growth), must stay > 0 and "
                               "finite; return 0 below the smallest radius, or remove the body",
                               (unsigned long long)w->clock.steps, (unsigned)w->bodies.slot[i] + 1,
                               (double)r, (double)radius[i], (double)rate);
    }
    if (result == DEM_OK && grown) {
        if (!demi_list_drop(w)) result = demi_no_memory(w, "dem_world_step");
    }
    for (i = 0; i < n && result == DEM_OK && grown; i++)
        if ((radius[i] < demi_radius(w, i) || radius[i] > demi_radius(w, i)) &&
            !demi_size_bad(w, i, radius[i], &mass)) demi_body_resize(w, i, radius[i], mass);
    demi_free(w, radius);
    w->grown = grown;
    return result;
}
/* Changes the radii before a step, if that is due, to those at its end. The time step is then
   chosen again if a body has become smaller: a growing one allows a longer step. */
static dem_result demi_radii_grow(dem_world *h) {
    const double until = h->clock.time + (double)h->clock.dt, passed = until - h->clock.grown;
    double grown = 0;
    dem_result result;
    int k;
    if (!h->desc.growth || !(passed > 0) || passed < (double)h->desc.growth_interval*(1 - 1e-9))
        return DEM_OK;
    result = demi_all(h, demi_member_grow);
    for (k = 0; k < demi_members(h); k++) grown = DEMI_MAX(grown, demi_member(h, k)->grown);
    if (result == DEM_OK) result = demi_agree(h, &grown, 1);
    if (result != DEM_OK) return result;
    h->clock.grown = until;
    for (k = 0; k < demi_members(h); k++) {
        dem_world *w = demi_member(h, k);
        w->clock.grown = until;
        if (grown > 0) demi_forces_outdated(w);
    }
    if (!(grown > 0)) return DEM_OK;
    demi_list_outdated(h);
    demi_forces_outdated(h);
    h->clock.press_since = h->clock.steps;      /* growing bodies press each other */
    if (grown > 2) demi_dt_outdated(h);
    return DEM_OK;
}
static int demi_growth_on(const dem_world *h) { return h->desc.growth != 0; }
