/* ---------------------------------------------------------------------------------------------
   >>team
   The worlds that step together. There is one step (>>step). It runs its phases on every member of
   a team; between phases the members exchange and agree on numbers. A single world is the only
   member: then an exchange does nothing, and an agreement returns the member's own numbers. >>slabs
   provides the exchange between slabs and between processes. Owns nothing.
   --------------------------------------------------------------------------------------------- */

/* The number of members in this process, and member k. h: the head, or a single world. */
static int demi_members(const dem_world *h) { return h->team ? h->team->count : 1; }
static dem_world *demi_member(const dem_world *h, int k) {
    return h->team ? h->team->members[k] : (dem_world *)h;
}
/* Runs a task on each member. A single world returns the result of the task; a team returns DEM_OK
   and keeps the results until the next agreement. */
static dem_result demi_all(dem_world *h, dem_result (*task)(dem_world *member)) {
    return h->team ? h->team->all(h, task) : task(h);
}
/* Returns the failure of any member since the last agreement, DEM_OK if there was none. most
   (count): replaced by the maxima over all processes. */
static dem_result demi_agree(dem_world *h, double *most, int count) {
    return h->team ? h->team->agree(h, most, count) : DEM_OK;
}
static dem_result demi_all_agree(dem_world *h, dem_result (*task)(dem_world *member)) {
    const dem_result result = demi_all(h, task);
    return result == DEM_OK ? demi_agree(h, 0, 0) : result;
}
/* Copies the time step from the head to the members. */
static void demi_dt_share(dem_world *h) {
    int k;
    for (k = 0; k < demi_members(h); k++) {
        dem_world *w = demi_member(h, k);
        w->clock.dt = h->clock.dt;
        w->clock.assumed_speed = h->clock.assumed_speed;
        w->stage.dt_valid = h->stage.dt_valid;
    }
}
static dem_result demi_member_finish(dem_world *w) { demi_finish(w); return DEM_OK; }
