/* ---------------------------------------------------------------------------------------------
   >>team
   The worlds that step together: a single world, or the slabs of a domain decomposition. There is
   one step (>>step), which runs its phases on every member of a team. Between phases the members
   exchange data of ghost particles and agree on maxima and failures. A single world has no team and
   is its own only member: an exchange then does nothing, and an agreement returns the member's own
   numbers. struct demi_team in >>layout lists the functions of a team; >>slabs-step provides them
   for slabs. At the end, the number of threads of a single world. Owns w->threads.
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

/* --- threads. desc.threads is the largest number. Threads can be slower than one: in a small
   scene, or if another program keeps a core busy, since each parallel loop then waits for the
   thread that does not run. So steps are timed, and half the present number, one, and twice the
   present number are tried in turns. A trial ends when it has lost the time of four steps. After a
   failed trial the world waits for 20 times the lost time, at least 400 steps, and longer each
   time; after a successful one it tries again at once. Trials take at most some 5 % of the time.
   Steps with a rebuild are not counted. With DEM_THREADS_FIXED the number is that of the
   desc. --- */
enum { DEMI_THREADS_STEPS = 12 };                  /* steps of a trial */
/* True if the number of threads of a world is to be chosen. */
static int demi_threads_varies(const dem_world *h) {
    return !h->threads.fixed && !h->team && h->desc.threads > 1;
}
static void demi_threads_begin(dem_world *h) {
    int k;
    for (k = 0; k < demi_members(h); k++) {
        demi_threads *c = &demi_member(h, k)->threads;
        if (!c->best) c->best = c->now = demi_member(h, k)->desc.threads;
    }
    h->threads.rebuilds = h->clock.rebuilds;
    if (demi_threads_varies(h)) h->threads.begun = demi_clock();
}
/* The number of threads to try next: half as many as now, one, or twice as many, in turns. `slow`:
   steps have become slower, perhaps since another program keeps cores busy. */
static int demi_threads_other(demi_threads *c, int most, int slow) {
    int k, n = c->best;
    for (k = 0; k < 3 && n == c->best; k++) {
        c->turn = slow && !k ? 1 : (c->turn + 1)%3;
        n = c->turn == 0 ? DEMI_MAX(c->best/2, 1) : c->turn == 1 ? 1 : DEMI_MIN(2*c->best, most);
    }
    return n;
}
/* Starts a measurement with `now` threads, which may be `best`. */
static void demi_threads_try(demi_threads *c, int now) {
    c->now = now;
    c->steps = 0;
    c->sum = 0;
}
/* Decides by the time of a step, s, how many threads take the next one. */
static void demi_threads_judge(dem_world *w, double took) {
    demi_threads *c = &w->threads;
    const int first = !(c->cost > 0), trial = c->now != c->best;
    double lost;
    if (!trial) c->since += took;
    if (w->clock.rebuilds != c->rebuilds) return;
    c->sum += took;
    c->steps++;
    lost = c->sum - c->steps*c->cost;
    if (trial) {
        const int worse = lost > 4*c->cost;
        if (!worse && c->steps < DEMI_THREADS_STEPS) return;
        c->wait = DEMI_MAX(20*lost, DEMI_MAX(400*c->cost, DEMI_MIN(2*c->wait, 10)));
        if (!worse && c->sum < 0.97*c->steps*c->cost) {
            c->best = c->now;
            c->cost = c->sum/c->steps;
            c->wait = 0;                        /* perhaps farther the same way */
        }
        c->since = 0;
        demi_threads_try(c, c->best);
    } else {
        const int slow = !first && lost > 2*DEMI_THREADS_STEPS*c->cost;
        if (c->steps < (first ? 2 : DEMI_THREADS_STEPS) && !slow) return;
        c->cost = first ? c->sum/c->steps : (c->cost + c->sum/c->steps)/2;
        demi_threads_try(c, first || slow || c->since > c->wait
                      ? demi_threads_other(c, w->desc.threads, slow) : c->best);
    }
}
static void demi_threads_end(dem_world *w) {
    if (demi_threads_varies(w)) demi_threads_judge(w, demi_clock() - w->threads.begun);
}
