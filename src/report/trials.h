/* ---------------------------------------------------------------------------------------------
   >>trials
   Trials (dem_trials_run): how much a numerical choice costs and how much it changes the results,
   measured on copies of the user's scene. A row describes a trial: time step, stiffness or contact
   law. Each trial runs several times from positions that hardly differ, because collisions amplify
   tiny differences: a change counts only if it exceeds this statistical scatter. Copies are made
   and freed within the call; the world itself takes no step. The observables shipped with dem.h
   come first; their declarations in the public half describe them.
   --------------------------------------------------------------------------------------------- */
DEM_API double dem_observer_height(const dem_world *w, void *user) {
    const dem_totals t = dem_totals_get(w);
    dem_vec3 up;
    (void)user;
    if (!w) return 0;
    up = demi_dot(w->desc.gravity, w->desc.gravity) > 0
        ? demi_scale(w->desc.gravity, -1/demi_length(w->desc.gravity)) : demi_v(0, 0, 1);
    return t.centre[0]*(double)up.x + t.centre[1]*(double)up.y + t.centre[2]*(double)up.z;
}
DEM_API double dem_observer_kinetic(const dem_world *w, void *user) {
    const dem_totals t = dem_totals_get(w);
    (void)user;
    return t.kinetic + t.rotational;
}
DEM_API double dem_observer_contacts(const dem_world *w, void *user) {
    const dem_counters c = dem_counters_get(w);
    (void)user;
    return w && w->bodies.count ? (2.0*c.contacts + c.wall_contacts)/w->bodies.count : 0;
}
DEM_API double dem_observer_walls(const dem_world *w, void *user) {
    double sum = 0;
    int i;
    (void)user;
    for (i = 0; w && i < w->wall_count; i++) sum += (double)demi_length(w->walls[i].loads.force);
    return sum;
}

/* Contact laws that a trial replaces; number of samples in the second half of a run. */
enum { DEMI_TRY_NORMAL = 1, DEMI_TRY_TANGENT = 2, DEMI_TRY_SAMPLES = 32 };
/* A trial. step: factor on dt/contact time; stiffness: factor on moduli and stiffnesses; law:
   DEMI_TRY_... or 0. */
typedef struct demi_try { const char *name; double step, stiffness; int law; } demi_try;
static const demi_try demi_tries[DEM_TRIALS] = {
    {"as it is",           1,    1,   0},       /* must be the first */
    {"step doubled",       2,    1,   0},
    {"step halved",        0.5,  1,   0},
    {"step quartered",     0.25, 1,   0},
    {"10 times softer",    1,    0.1, 0},
    {"4 times stiffer",    1,    4,   0},
    {"other normal law",   1,    1,   DEMI_TRY_NORMAL},
    {"other friction law", 1,    1,   DEMI_TRY_TANGENT}};
/* Returns the normal law to try instead of the one in force, or -1 if none fits. Hertz's law and
   linear springs replace each other if all pairs have moduli, from which both can be computed. A
   user-defined law and a hysteretic law have no counterpart. */
static int demi_try_normal(const dem_world *w) {
    int i, j, moduli = 1;
    for (i = 0; i < w->material_count; i++)
        for (j = 0; j < w->material_count; j++)
            moduli &= w->pairs[i*DEMI_MATERIALS + j].given.young_eff > 0;
    if (w->desc.law || !moduli || demi_normal_is(w, DEMI_BRANCHED)) return -1;
    return demi_normal_is(w, DEMI_HERTZIAN) ? DEM_NORMAL_LINEAR : DEM_NORMAL_HERTZ;
}
/* Returns the tangential law to try instead of the one in force, or -1 if none fits or no pair has
   friction. A spring replaces any other law; with Hertz's law, [THO13] replaces a spring. */
static int demi_try_tangent(const dem_world *w) {
    if (w->desc.law || !demi_pairs_rub(w).friction ||
        demi_tangent_meant(w) == DEM_TANGENT_NONE) return -1;
    if (demi_tangent_meant(w) != DEM_TANGENT_SPRING) return DEM_TANGENT_SPRING;
    return demi_normal_is(w, DEMI_HERTZIAN) ? DEM_TANGENT_MINDLIN_RESCALED : -1;
}
/* True if the trial makes sense in this scene. The stiffness of a user-defined law is unknown, so
   trials of stiffness then do not. */
static int demi_try_fits(const dem_world *w, const demi_try *row) {
    if (row->law == DEMI_TRY_NORMAL) return demi_try_normal(w) >= 0;
    if (row->law == DEMI_TRY_TANGENT) return demi_try_tangent(w) >= 0;
    return !w->desc.law || row->stiffness == 1.0;
}
static const char *demi_try_name(const dem_world *w, const demi_try *row) {
    if (row->law == DEMI_TRY_NORMAL)
        return demi_try_normal(w) == DEM_NORMAL_LINEAR ? "linear springs" : "Hertz's law";
    if (row->law == DEMI_TRY_TANGENT)
        return demi_try_tangent(w) == DEM_TANGENT_SPRING ? "friction by a spring"
            : "Mindlin's friction";
    return row->name;
}
/* Multiplies all moduli and stiffnesses by a factor. Those of materials determine the time step,
   those of pairs the forces; both are changed, since the user may have set a pair to values other
   than those mixed from its materials. */
static void demi_stiffen(dem_world *t, dem_real factor) {
    int i, j;
    for (i = 0; i < t->material_count; i++) {
        dem_material_desc *m = &t->materials[i];
        m->young *= factor;
        m->stiffness *= factor;
        m->stiffness_unloading *= factor;
        m->stiffness_adhesion *= factor;
    }
    for (i = 0; i < t->material_count; i++)
        for (j = i; j < t->material_count; j++) {
            dem_pair p = t->pairs[i*DEMI_MATERIALS + j].given;
            p.young_eff *= factor;
            p.shear_eff *= factor;
            p.stiffness *= factor;
            p.stiffness_adhesion *= factor;
            p.normal_damping *= DEMI_SQRT(factor);     /* keeps the damping ratio */
            demi_pair_put(t, i, j, &p);
        }
}
/* Applies a trial to the copy t. The time step keeps its ratio to the contact time, times
   row->step. If dem.h chooses the step (desc.dt 0), dt_share applies this factor to every choice
   during the run. */
static void demi_try_set(dem_world *t, const demi_try *row) {
    const double dt = (double)t->clock.dt;
    dem_advice was, is;
    demi_finish(t);
    demi_advise(t, &was);
    if (row->law == DEMI_TRY_NORMAL) t->desc.normal_law = (dem_normal_law)demi_try_normal(t);
    if (row->law == DEMI_TRY_TANGENT) t->desc.tangent_law = (dem_tangent_law)demi_try_tangent(t);
    demi_stiffen(t, (dem_real)row->stiffness);
    demi_advise(t, &is);
    t->dt_share = row->step;
    if (t->desc.dt > 0) {
        t->desc.dt = (dem_real)(dt*row->step);
        if (was.contact_time > 0 && is.contact_time > 0)
            t->desc.dt *= is.contact_time/was.contact_time;
    }
    demi_pairs_changed(t);
    demi_halves_outdated(t);
}
/* Moves every body that is not fixed by at most 1e-6 of its radius along each axis, at random; seed
   0 moves none. This is far less than any relevant overlap, and enough for differences between runs
   to appear soon, since collisions amplify them as they amplify the effect of a trial. A change in
   the last bit would take long to grow, and the scatter would look smaller than it is. */
static void demi_try_shake(dem_world *t, uint64_t seed) {
    int i, k;
    for (i = 0; i < t->bodies.count && seed; i++)
        for (k = 0; k < (t->desc.planar ? 2 : 3) && t->bodies.inv_mass[i] > 0; k++)
            t->bodies.pos[4*i + k] += demi_radius(t, i)*
                (dem_real)(1e-6*(2*demi_uniform(&seed) - 1));
}
/* Runs the copy t and adds the means of the observables over the second half of the run to sum. The
   first half lets transients of the change decay: a heap sinks a little when it becomes softer, and
   oscillates a little when it becomes stiffer. */
static dem_result demi_try_run(dem_world *t, const dem_trials *all, double *sum) {
    dem_result result = DEM_OK;
    int k, e;
    for (k = 0; k <= DEMI_TRY_SAMPLES && result == DEM_OK; k++) {
        result = dem_world_run(t, all->duration/2/(k ? (int)DEMI_TRY_SAMPLES : 1), 0, 0);
        for (e = 0; e < all->observable_count && k && result == DEM_OK; e++) {
            const dem_observable *o = &all->observables[e];
            double value;
            DEMI_USER(t, "dem_trials_run", 1, value = o->function(t, o->user))
            sum[e] += value/(int)DEMI_TRY_SAMPLES;
            if (!demi_finite_double(value))
                result = demi_fail(t, DEM_ERROR_UNSTABLE, "%s is not finite", o->name);
        }
    }
    return result;
}
/* Returns the half width of the 95 % confidence interval for the difference of two means of n runs
   each, in standard errors: Student's t for 2n - 2 degrees of freedom, by its expansion about the
   normal distribution. */
static double demi_student(int n) {
    const double v = 1/(2.0*n - 2);
    return 1.96 + v*(2.372 + v*(2.822 + v*(2.556 + v*1.59)));
}
/* Computes the reference, and drift and promise of every trial (see dem_trial), after all have run.
   The reference is the trial with the smallest step, because a smaller step is always more
   accurate; whether softer or stiffer grains are closer to reality, only the user knows. */
static void demi_trials_judge(dem_trials *out) {
    int i, e;
    for (i = 0; i < out->count; i++)            /* among trials that reached their end */
        if (out->trial[i].done == out->seeds &&
            out->trial[i].step < out->trial[out->reference].step) out->reference = i;
    for (i = 0; i < out->count; i++) {
        const dem_trial *ref = &out->trial[out->reference];
        dem_trial *t = &out->trial[i];
        t->promise = t->done < out->seeds ? HUGE_VAL : 0;
        for (e = 0; e < out->observable_count && t->done == out->seeds; e++) {
            double scale = out->observables[e].scale, chance;
            if (!(scale > 0)) scale = fabs(ref->value[e]);
            if (!(scale > 0)) scale = DEMI_MAX(fabs(t->value[e]), 1e-300);
            t->drift[e] = (t->value[e] - ref->value[e])/scale;
            chance = demi_student(out->seeds)*sqrt(t->error[e]*t->error[e] +
                                                   ref->error[e]*ref->error[e])/scale;
            t->promise = DEMI_MAX(t->promise, fabs(t->drift[e]) + chance);
        }
    }
}
/* Chooses the best trial, the cheapest whose promise is within the tolerance, and writes the
   advice. If the unchanged scene is within the tolerance, another trial replaces it only if it
   saves a tenth of the time. If no trial is within the tolerance, not even the reference compared
   with itself, the statistical scatter is larger than the tolerance. */
static void demi_trials_advise(dem_trials *out) {
    const dem_trial *ref = &out->trial[out->reference], *scene = &out->trial[0], *best;
    const double now = scene->seconds;
    int i, found = -1;
    for (i = 0; i < out->count; i++) {
        const dem_trial *t = &out->trial[i];
        if (t->done < out->seeds || t->promise > out->tolerance) continue;
        if (found < 0 || t->seconds < (found ? 1 : 0.9)*out->trial[found].seconds) found = i;
    }
    out->best = found < 0 ? out->reference : found;
    best = &out->trial[out->best];
    if (found < 0)
        demi_words(out->advice, sizeof out->advice, "chance alone changes the observables by up to "
                   "%.2g of their scale, more than the tolerance of %.2g: give a longer duration, "
                   "more seeds, or observables that are averages", ref->promise, out->tolerance);
    else if (!found)
        demi_words(out->advice, sizeof out->advice, "keep the scene as it is: all observables are "
                 "within %.2g of those of \"%s\" (tolerance %.2g), and no trial within it saves a "
                 "tenth of the time", best->promise, ref->name, out->tolerance);
    else if (best->seconds < now)
        demi_words(out->advice, sizeof out->advice, "use \"%s\": all observables are within %.2g "
                 "of those of \"%s\" (tolerance %.2g), in %.2g of the time that the scene takes as "
                 "it is", best->name, best->promise, ref->name, out->tolerance, best->seconds/now);
    else
        demi_words(out->advice, sizeof out->advice, "use \"%s\": as it is, the scene is only "
                   "within %.2g of \"%s\" (tolerance %.2g); this trial is within %.2g, and takes "
                   "%.2g times as long", best->name, scene->promise, ref->name, out->tolerance,
                   best->promise, best->seconds/now);
}
/* Makes all runs of one trial, each on a new copy. A run that does not start or becomes unstable is
   a result of the trial (trial->refusal) and not an error of the call: the step may be too large,
   which is worth knowing. Returns an error only if memory runs out. */
static dem_result demi_trial_run(dem_world *w, const char *state, size_t size, const demi_try *row,
                                 dem_trials *out, dem_trial *trial) {
    double value[16][DEM_OBSERVABLES], wall = 0;
    int e, k;
    memset(value, 0, sizeof value);
    for (k = 0; k < out->seeds && !*trial->refusal; k++) {
        dem_world *t = demi_twin_in_state(w, state, size);
        double begun;
        if (!t) return demi_no_memory(w, "dem_trials_run");
        demi_try_set(t, row);
        demi_try_shake(t, (uint64_t)k);
        begun = demi_clock();
        if (demi_try_run(t, out, value[k]) == DEM_OK) trial->done++;
        else demi_words(trial->refusal, sizeof trial->refusal, "%.199s", t->error);
        trial->dt = (double)t->clock.dt;
        wall += demi_clock() - begun;
        demi_twin_free(w, t);
    }
    if (trial->done < out->seeds) return DEM_OK;
    trial->seconds = wall/out->seeds/out->duration;
    for (e = 0; e < out->observable_count; e++) {
        double off = 0;
        for (k = 0; k < out->seeds; k++) trial->value[e] += value[k][e]/out->seeds;
        for (k = 0; k < out->seeds; k++)
            off += (value[k][e] - trial->value[e])*(value[k][e] - trial->value[e]);
        trial->error[e] = sqrt(off/(out->seeds - 1.0)/out->seeds);
    }
    return DEM_OK;
}
#define DEMI_TRIED(field, type, how, most, unit) \
    DEMI_LIMITED(dem_trials_desc, field, type, how, most, unit)
static const demi_field_row demi_trials_rows[] = {
    DEMI_TRIED(duration, 'd', DEMI_OVER, DBL_MAX, "s"),
    DEMI_TRIED(budget, 'd', DEMI_FROM, DBL_MAX, "s"),
    DEMI_TRIED(tolerance, 'd', DEMI_FROM, DBL_MAX, ""), DEMI_TRIED(seeds, 'i', DEMI_FROM, 16, ""),
    DEMI_TRIED(observable_count, 'i', DEMI_FROM, DEM_OBSERVABLES, ""),
    DEMI_ROW_FREE(dem_trials_desc, observables), DEMI_ROW_FREE(dem_trials_desc, progress),
    DEMI_ROW_FREE(dem_trials_desc, user), DEMI_ROW_END};
/* Fails if the desc is not valid or the scene cannot be compared. */
static dem_result demi_trials_check(dem_world *w, const dem_trials_desc *d) {
    const char *call = "dem_trials_run";
    const int lost = demi_body_lost(w);
    int e;
    if (!demi_response_is(w, DEMI_LASTING))
        return demi_refuse(w, call, "contacts of this world are impulses, but trials vary the "
                           "steps, stiffnesses and laws of springs; compare runs with other dt, "
                           "sweeps and tolerance instead");
    if (demi_rows_check(w, call, demi_trials_rows, d, "",
                        "start from DEM_TRIALS_DESC and set duration")) return DEM_ERROR_ARGUMENT;
    if (d->seeds == 1) return demi_refuse(w, call, "seeds is 1, must be 2 to 16 (0 means 3)");
    for (e = 0; e < d->observable_count; e++)
        if (!d->observables[e].function || !d->observables[e].name)
            return demi_refuse(w, call, "observable %d has no function or no name; give both, as "
                               "{\"height\", \"m\", dem_observer_height, 0, 0}", e + 1);
    for (e = 0; e < d->observable_count; e++)
        if (!(d->observables[e].scale >= 0) || !demi_finite_double(d->observables[e].scale))
            return demi_refuse(w, call, "the scale of observable %d is %g, must be finite and >= "
                               "0; 0 means its own value in the reference", e + 1,
                               d->observables[e].scale);
    if (!w->bodies.count)
        return demi_refuse(w, call, "there are no bodies to compare; add some, or run until some "
                           "are fed");
    if (lost < 0) return DEM_OK;
    return demi_refuse(w, call, "body %u no longer has a finite position, velocity and force: the "
                       "run has blown up; go back to an earlier checkpoint",
                       (unsigned)w->bodies.slot[lost] + 1);
}
/* Shortens out->duration if the trials would otherwise take longer than the budget (s of wall
   time). The estimate is the time of 20 steps of a copy; the number of steps grows with
   stiffness^0.4, as for Hertz's law. Fails if the scene does not run, or if a run has fewer than 64
   steps. */
static dem_result demi_advise_plan(dem_world *w, const char *state, size_t size, double budget,
                                   dem_trials *out) {
    dem_world *t = demi_twin_in_state(w, state, size);
    const double asked = out->duration;
    double steps = 0, each, begun;
    int k;
    dem_result result;
    if (!t) return demi_no_memory(w, "dem_trials_run");
    result = dem_world_step(t, 5);
    begun = demi_clock();
    if (result == DEM_OK) result = dem_world_step(t, 20);
    each = (demi_clock() - begun)/20;
    for (k = 0; k < DEM_TRIALS; k++)
        if (demi_try_fits(w, &demi_tries[k]))
            steps += out->seeds/(double)t->clock.dt/demi_tries[k].step*
                demi_pow(demi_tries[k].stiffness, 0.4);
    if (each*steps*out->duration > budget) out->duration = budget/each/steps;
    if (result != DEM_OK) demi_fail(w, result, "dem_trials_run: the scene as it is fails: %.400s",
                                    t->error);
    else if (asked < 64*(double)t->clock.dt)
        result = demi_refuse(w, "dem_trials_run", "duration is %g s, must be at least 64 steps of "
                             "%g s; set a duration in which the observables settle", asked,
                             (double)t->clock.dt);
    else if (out->duration < 64*(double)t->clock.dt)
        result = demi_refuse(w, "dem_trials_run", "%g s of wall time allow %g s of this scene in "
                             "each trial, must be at least 64 steps of %g s; give a larger budget, "
                             "fewer seeds, or a smaller part of the scene", budget, out->duration,
                             (double)t->clock.dt);
    demi_twin_free(w, t);
    return result;
}
/* Sets the scales of the default observables. height: m, of the centre of mass above the lowest
   point of the grains. kinetic: J, the present energy plus what all grains would gain if they fell
   by their radius. */
static void demi_usual_scales(const dem_world *w, dem_trials *out) {
    const double g = (double)demi_length(w->desc.gravity);
    const dem_vec3 up = g > 0 ? demi_scale(w->desc.gravity, (dem_real)(-1/g)) : demi_v(0, 0, 1);
    double lowest = 1e300, fall = 0;
    int i;
    for (i = 0; i < w->bodies.count; i++) {
        const double r = (double)demi_radius(w, i);
        if (!(w->bodies.inv_mass[i] > 0)) continue;
        lowest = DEMI_MIN(lowest, (double)demi_dot(demi_at(w->bodies.pos + 4*i), up) - r);
        fall += (double)w->bodies.mass[i]*g*r;
    }
    out->observables[0].scale = DEMI_MAX(dem_observer_height(w, 0) - lowest, 0);
    out->observables[1].scale = dem_observer_kinetic(w, 0) + fall;
}
DEM_API dem_result dem_trials_run(dem_world *w, const dem_trials_desc *d, dem_trials *out) {
    static const dem_observable usual[] = {
        {"height", "m", dem_observer_height, 0, 0}, {"kinetic", "J", dem_observer_kinetic, 0, 0},
        {"contacts", "", dem_observer_contacts, 0, 0}};
    const demi_try *rows[DEM_TRIALS];
    const double begun = demi_clock();
    demi_calling was;
    char *state;
    size_t size;
    dem_result result;
    int k, stop = 0;
    if (demi_null(w, __func__, d, "desc") || demi_null(w, __func__, out, "trials"))
        return DEM_ERROR_ARGUMENT;
    if (demi_unbuilt(w, __func__) != DEM_OK || demi_trials_check(w, d) != DEM_OK)
        return DEM_ERROR_ARGUMENT;
    memset(out, 0, sizeof *out);
    out->duration = d->duration;
    out->tolerance = d->tolerance > 0 ? d->tolerance : 0.02;
    out->seeds = d->seeds ? d->seeds : 3;
    out->observable_count = d->observable_count ? d->observable_count : 3;
    memcpy(out->observables, d->observable_count ? d->observables : usual,
           (size_t)out->observable_count*sizeof *usual);
    if (!d->observable_count) demi_usual_scales(w, out);
    if (!w->facets_valid && !demi_surfaces_make(w)) return demi_no_memory(w, __func__);
    result = demi_dt_settle(w);                 /* fails as a run would */
    if (result != DEM_OK) return result;
    state = demi_state_keep(w, &size);
    if (!state) return demi_no_memory(w, __func__);
    was = demi_calls(w, __func__, 1);       /* copies call the user's functions */
    result = demi_advise_plan(w, state, size, d->budget > 0 ? d->budget : 60, out);
    for (k = 0; k < DEM_TRIALS; k++)
        if (demi_try_fits(w, &demi_tries[k])) rows[out->count++] = &demi_tries[k];
    for (k = 0; k < out->count && result == DEM_OK; k++) {
        dem_trial *trial = &out->trial[k];
        trial->name = demi_try_name(w, rows[k]);
        trial->step = rows[k]->step;
        trial->stiffness = rows[k]->stiffness;
        result = demi_trial_run(w, state, size, rows[k], out, trial);
        if (result == DEM_OK && d->progress)
            DEMI_USER(w, __func__, 1, stop = d->progress(
                w, (k + 1.0)/out->count, (demi_clock() - begun)*(out->count - k - 1)/(k + 1),
                d->user))
        if (result == DEM_OK && stop)
            result = demi_fail(w, DEM_ERROR_STOPPED, "dem_trials_run: stopped by the progress "
                               "function after %d of %d trials", k + 1, out->count);
    }
    demi_called(w, was);
    demi_free(w, state);
    if (result != DEM_OK) return result;
    if (out->trial[0].done < out->seeds)
        return demi_fail(w, DEM_ERROR_UNSTABLE, "dem_trials_run: the scene as it is does not run: "
                         "%.300s", out->trial[0].refusal);
    demi_trials_judge(out);
    demi_trials_advise(out);
    return DEM_OK;
}
DEM_API void dem_trials_print(const dem_trials *t, FILE *out) {
    int i, e;
    if (!t || !out) return;
    demi_print(out, "trials     %d runs each of %.3g s; means of the second half +- standard "
               "error\n", t->seeds, t->duration);
    demi_print(out, "  %-20s %-9s %-9s", "", "dt [s]", "s per s");
    for (e = 0; e < t->observable_count; e++) {
        const dem_observable *o = &t->observables[e];
        char name[64];
        demi_words(name, sizeof name, o->unit && *o->unit ? "%s [%s]" : "%s", o->name, o->unit);
        demi_print(out, " %-22s", name);
    }
    demi_print(out, " within\n");
    for (i = 0; i < t->count; i++) {
        const dem_trial *trial = &t->trial[i];
        demi_print(out, "%c %-20s %-9.3g ", i == t->best ? '*' : ' ', trial->name, trial->dt);
        if (trial->done < t->seeds) { demi_print(out, "%.120s\n", trial->refusal); continue; }
        demi_print(out, "%-9.3g", trial->seconds);
        for (e = 0; e < t->observable_count; e++) {
            char value[64];
            demi_words(value, sizeof value, "%.5g +- %.1g", trial->value[e], trial->error[e]);
            demi_print(out, " %-22s", value);
        }
        demi_print(out, " %.2g%s\n", trial->promise, i == t->reference ? " (reference)" : "");
    }
    demi_print(out, "advice     %s\n", t->advice);
}
