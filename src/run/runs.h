/* ---------------------------------------------------------------------------------------------
   >>runs
   Runs of many steps: for a time, up to a time, or until the grains are at rest; and reports of
   progress. Owns the end of the last run (clock.run_end, run_steps) and the progress reported
   (look.tenths_told). Otherwise it calls public functions and reads the state after a step.
   --------------------------------------------------------------------------------------------- */

/* Calls the progress function, if there is one. Returns DEM_ERROR_STOPPED if it stops the run, else
   DEM_OK. done: fraction of the run, 0 to 1; since: wall time at the begin of `call`, s. */
static dem_result demi_progress(dem_world *w, const char *call, dem_progress_fn progress,
                                void *user, double done, double since) {
    const double left = (demi_clock() - since)*(1 - done)/DEMI_MAX(done, 1e-9);
    int stop = 0;
    if (progress)
        DEMI_USER(w, call, 0, stop = progress(w, done, done < 1 ? left : 0, user) && done < 1)
    return stop ? demi_fail(w, DEM_ERROR_STOPPED, "%s: stopped by the progress function at %g s",
                            call, w->clock.time) : DEM_OK;
}
/* Returns the time from which a run counts: where the last one should have ended, so that runs add
   up, or now if other steps were taken since. */
static double demi_run_from(const dem_world *w) {
    const demi_timing *c = &w->clock;
    return c->run_steps == c->steps && fabs(c->run_end - c->time) <= (double)c->dt ? c->run_end
                                                                                   : c->time;
}
/* Advances the world to the step nearest to `end`, s: so many steps are a time for all runs. */
static dem_result demi_run_until(dem_world *w, const char *call, double end,
                                 dem_progress_fn progress, void *user) {
    const double start = w->clock.time, begun = demi_clock();
    const uint64_t first = w->clock.steps;
    double last = begun;
    int chunk = 1;
    if (demi_unbuilt(w, call) != DEM_OK) return DEM_ERROR_ARGUMENT;
    if (progress) w->look.tenths_told = 0;      /* dem_world_settle reports for several runs */
    if (w->stage.moved) {                       /* it ran out of memory; its time has passed */
        const dem_result rest = dem_world_step(w, 1);
        if (rest != DEM_OK) return rest;
    }
    for (;;) {
        const double left = end - w->clock.time;
        double now;
        int steps = chunk;
        dem_result result = demi_dt_settle(w);
        if (result != DEM_OK) return result;
        if (left < (double)w->clock.dt/2) break;
        if (left/(double)w->clock.dt < chunk) steps = (int)(left/(double)w->clock.dt + 0.5);
        if (steps < 1) steps = 1;
        result = dem_world_step(w, steps);
        if (result != DEM_OK) return result;
        now = demi_clock();
        if (now - last > 0.1) {
            last = now;
            result = demi_progress(w, call, progress, user,
                                   (w->clock.time - start)/(end - start), begun);
            if (result != DEM_OK) return result;
        }
        /* short steps: read the clock less often */
        if (now - begun < 0.05*(double)(w->clock.steps - first) && chunk < 1000) chunk++;
    }
    w->clock.run_end = end;
    w->clock.run_steps = w->clock.steps;
    return demi_progress(w, call, progress, user, 1, begun);
}
DEM_API dem_result dem_world_run(dem_world *w, double seconds, dem_progress_fn progress,
                                 void *user) {
    if (demi_null(w, __func__, w, "world")) return DEM_ERROR_ARGUMENT;
    if (!demi_finite_double(seconds) || !(seconds >= 0) || !(seconds < 1e300))
        return demi_refuse(w, __func__, "seconds is %g, must be finite and >= 0", seconds);
    return demi_run_until(w, __func__, demi_run_from(w) + seconds, progress, user);
}

DEM_API dem_result dem_world_run_to(dem_world *w, double time, dem_progress_fn progress,
                                    void *user) {
    if (demi_null(w, __func__, w, "world")) return DEM_ERROR_ARGUMENT;
    if (!demi_finite_double(time) || time < w->clock.time - (double)w->clock.dt/2)
        return demi_refuse(w, __func__, "time is %g s, must be finite and not before now "
                           "(%g s); to go back in time, read a checkpoint", time, w->clock.time);
    return demi_run_until(w, __func__, time, progress, user);
}

/* Returns the largest speed, m/s, of the bodies that can move. *mean receives the root of the mean
   square speed, weighted by mass, m/s. */
static double demi_speeds(const dem_world *w, double *mean) {
    double sum = 0, most = 0, mass = 0;
    int i;
    for (i = 0; i < w->bodies.count; i++) {
        const dem_vec3 v = demi_at(w->bodies.vel + 4*i);
        const double vv = (double)demi_dot(v, v), m = (double)w->bodies.mass[i];
        if (!(w->bodies.inv_mass[i] > 0)) continue;
        sum += m*vv;
        mass += m;
        most = DEMI_MAX(most, vv);
    }
    *mean = mass > 0 ? sqrt(sum/mass) : 0;
    return sqrt(most);
}
/* Returns the speed below which grains count as at rest, m/s: `speed`, or if that is 0 a hundredth
   of the speed after a fall through the mean radius. *look receives the time between two tests, s:
   a fall through half a radius takes it, or without gravity a way of half a radius at that speed.
   So a body that is at rest only for an instant, at its highest point, does not pass all tests. */
static double demi_calm(const dem_world *w, double speed, double *look) {
    const double g = (double)demi_length(w->desc.gravity);
    double radius = w->feed_count ? demi_feed_at(w, 0)->lo[0] : 0;      /* of the first grains */
    int i;
    if (w->bodies.count) radius = 0;
    for (i = 0; i < w->bodies.count; i++) radius += (double)demi_radius(w, i)/w->bodies.count;
    if (!(speed > 0) && g > 0) speed = 0.01*sqrt(2*g*radius);
    *look = g > 0 ? sqrt(radius/g) : radius/2/DEMI_MAX(speed, 1e-300);
    return speed;
}
/* Returns the index of the first feed that has grains left to insert; -1: none has. */
static int demi_feed_coming(const dem_world *w) {
    int i = 0;
    while (i < w->feed_count && demi_feed_at(w, i)->state.done) i++;
    return i < w->feed_count ? i : -1;
}
/* Fails because the time of dem_world_settle is over. calm: so many tests found rest. */
static dem_result demi_unsettled(dem_world *w, double seconds, double speed, int calm) {
    const int i = demi_feed_coming(w);
    double mean, look, most = demi_speeds(w, &mean), below = demi_calm(w, speed, &look);
    if (i >= 0) {
        const dem_feed_state *f = &demi_feed_at(w, i)->state;
        return demi_fail(w, DEM_ERROR_STOPPED, "dem_world_settle: not at rest after %g s: feed %d "
                         "is not done (%llu grains inserted, %llu waiting for room), and grains "
                         "can rest only when it is; allow more time, a higher rate or a larger box",
                         seconds, i + 1, (unsigned long long)f->total,
                         (unsigned long long)f->waiting);
    }
    if (calm)
        return demi_fail(w, DEM_ERROR_STOPPED, "dem_world_settle: %g s is too short: rest takes "
                         "three tests, %.3g s apart; allow at least %.2g s", seconds, look,
                         2.2*look);
    return demi_fail(w, DEM_ERROR_STOPPED, "dem_world_settle: not at rest after %g s: mean speed "
                     "%.3g m/s, largest %.3g m/s, must be below %.3g and %.3g; allow more time, "
                     "or find what drives the grains", seconds, mean, most, below, 10*below);
}
DEM_API dem_result dem_world_settle(dem_world *w, double seconds, dem_real speed,
                                    dem_progress_fn progress, void *user) {
    if (demi_null(w, __func__, w, "world")) return DEM_ERROR_ARGUMENT;
    const double begun = demi_clock(), start = w->clock.time;
    const double end = demi_run_from(w) + seconds;
    double look, below = demi_calm(w, (double)speed, &look), last = begun;
    int i, calm = 0;
    if (!demi_finite_double(seconds) || !(seconds > 0) || !(speed >= 0) || !demi_finite(speed) ||
        (!(below > 0) && (w->bodies.count || demi_feed_coming(w) >= 0)))
        return demi_refuse(w, __func__, "seconds is %g and speed is %g m/s; both must be finite, "
                           "seconds > 0, speed >= 0, and speed > 0 without gravity, from which its "
                           "default follows", seconds, (double)speed);
    for (i = 0; i < w->feed_count; i++) {
        const demi_feed *f = demi_feed_at(w, i);
        if (!f->desc.limited && !(f->desc.end > 0))
            return demi_refuse(w, __func__, "feed %d has limited 0 and end 0 s, one of "
                               "them must be > 0, or the feed never ends; set one of them, or use "
                               "dem_world_run", i + 1);
    }
    w->look.tenths_told = 0;
    while (w->bodies.count || demi_feed_coming(w) >= 0) {
        double mean, most = demi_speeds(w, &mean);
        dem_result result;
        below = demi_calm(w, (double)speed, &look);
        calm = demi_feed_coming(w) < 0 && mean < below && most < 10*below ? calm + 1 : 0;
        if (calm > 2) break;
        if (end - w->clock.time < (double)w->clock.dt/2)
            return demi_unsettled(w, seconds, (double)speed, calm);
        if (!(demi_dot(w->desc.gravity, w->desc.gravity) > 0)) look = DEMI_MIN(look, seconds/4);
        look = DEMI_MAX(look, (double)w->clock.dt);
        result = demi_run_until(w, __func__, DEMI_MIN(demi_run_from(w) + look, end), 0, 0);
        if (result != DEM_OK) return result;
        if (demi_clock() - last > 0.1) {
            last = demi_clock();
            result = demi_progress(w, __func__, progress, user,
                                   (w->clock.time - start)/seconds, begun);
            if (result != DEM_OK) return result;
        }
    }
    return demi_progress(w, __func__, progress, user, 1, begun);
}

/* demi_isatty: true if a file is a terminal. Standard C has no such function. On the systems below
   that of the C library has another name, as readlink in >>write; on others it returns 1. */
#if (defined(__unix__) || defined(__linux__)) && (defined(__GNUC__) || defined(__TINYC__)) && \
    !defined(__CYGWIN__)
int demi_isatty(int file) __asm__("isatty");
int demi_fileno(FILE *file) __asm__("fileno");
#elif defined(__APPLE__) && defined(__GNUC__)
int demi_isatty(int file) __asm__("_isatty");
int demi_fileno(FILE *file) __asm__("_fileno");
#else
static int demi_isatty(int file) { (void)file; return 1; }
static int demi_fileno(FILE *file) { (void)file; return 0; }
#endif
DEM_API int dem_progress_print(const dem_world *w, double done, double seconds_left, void *user) {
    if (demi_null_look(w, __func__, user, "user")) return 0;
    FILE *out = (FILE *)user;
    const int line = !demi_isatty(demi_fileno(out)), tenths = (int)(10*done + 1e-9);
    char crushed[128];
    if (line && tenths <= w->look.tenths_told) return 0;
    ((dem_world *)w)->look.tenths_told = tenths;
    demi_print(out, "%s%5.1f %%  t = %-10.4g s  %d grains  %.0f s left   ", line ? "" : "\r",
               100*done, w->clock.time, w->bodies.count, seconds_left);
    if (w->booked.unsolved)
        demi_print(out, "%llu steps above the tolerance   ",
                   (unsigned long long)w->booked.unsolved);
    if (*demi_crushed_text(w, crushed, sizeof crushed))
        demi_print(out, "overlap %.2g R %s   ", w->booked.overlap_max, crushed);
    if (line || done >= 1) fputc('\n', out);
    fflush(out);
    return 0;
}

DEM_API double dem_world_time_get(const dem_world *w) {
    if (demi_null_look(w, __func__, w, "world")) return 0;
    return w->clock.time;
}
DEM_API uint64_t dem_world_steps_get(const dem_world *w) {
    if (demi_null_look(w, __func__, w, "world")) return 0;
    return demi_steps_done(w);
}
