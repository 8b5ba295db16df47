/* ---------------------------------------------------------------------------------------------
   >>team
   The worlds that step together: a single world, or the slabs of a domain decomposition. There is
   one step (>>step), which runs its phases on every member of a team. Between phases the members
   exchange data of ghost particles and agree on maxima and failures. A single world has no team and
   is its own only member: an exchange then does nothing, and an agreement returns the member's own
   numbers. struct demi_team in >>layout lists the functions of a team; >>slabs-step provides them
   for slabs. Owns nothing.
   --------------------------------------------------------------------------------------------- */

/* Return the number of members in this process, and member k. In all parts `h` is the head of a
   team, or a single world, and `w` is a member. */
static int demi_members(const dem_world *h) { return h->team ? h->team->count : 1; }
static dem_world *demi_member(const dem_world *h, int k) {
    return h->team ? h->team->members[k] : (dem_world *)h;
}
/* Runs a task on each member. A single world returns the result of the task. A team always returns
   DEM_OK; it stores the results, and the next agreement returns a failure. */
static dem_result demi_all(dem_world *h, dem_result (*task)(dem_world *member)) {
    return h->team ? h->team->all(h, task) : task(h);
}
/* Returns a failure of any member since the last agreement, or DEM_OK. Replaces each of the `count`
   values of `most` by its maximum over all processes; count <= 7 (demi_slabs_agree). */
static dem_result demi_agree(dem_world *h, double *most, int count) {
    return h->team ? h->team->agree(h, most, count) : DEM_OK;
}
/* Runs a task on each member and returns a failure of any of them. */
static dem_result demi_all_agree(dem_world *h, dem_result (*task)(dem_world *member)) {
    const dem_result result = demi_all(h, task);
    return result == DEM_OK ? demi_agree(h, 0, 0) : result;
}
/* Copies the time step, and the impact speed it was chosen for, from the head to the members. */
static void demi_dt_share(dem_world *h) {
    int k;
    for (k = 0; k < demi_members(h); k++) {
        dem_world *w = demi_member(h, k);
        w->clock.dt = h->clock.dt;
        w->clock.assumed_speed = h->clock.assumed_speed;
        w->stage.dt_valid = h->stage.dt_valid;
    }
}
/* Completes the half kick that the last step left open (demi_finish), as a task for demi_all. */
static dem_result demi_member_finish(dem_world *w) { demi_finish(w); return DEM_OK; }
