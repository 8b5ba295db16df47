/* ---------------------------------------------------------------------------------------------
   >>impacts
   Measurements of recorded contacts (>>events): spectra of impact energies, collision rates, wear.
   Reads w->events only.
   --------------------------------------------------------------------------------------------- */

/* Returns the lower limit of a bin, J. */
static double demi_impact_limit(int bin) { return demi_pow(10, bin/5.0 - 18); }
/* True if the materials x and y (indices) are those of ids a and b, of which 0 means any. */
static int demi_impacts_fit(int x, int y, dem_material a, dem_material b) {
    return ((!a.id || a.id == x + 1) && (!b.id || b.id == y + 1)) ||
        ((!a.id || a.id == y + 1) && (!b.id || b.id == x + 1));
}
DEM_API dem_result dem_impacts_get(dem_world *w, dem_material a, dem_material b, dem_impacts *out) {
    int i, k;
    if (demi_null_look(w, __func__, out, "impacts")) return DEM_ERROR_ARGUMENT;
    if (demi_events_needed(w, __func__) != DEM_OK) return DEM_ERROR_ARGUMENT;
    if (a.id < 0 || a.id > w->material_count || b.id < 0 || b.id > w->material_count)
        return demi_refuse(w, __func__, "material %d does not exist; there are %d, and id 0 means "
                           "any", (int)(a.id < 0 || a.id > w->material_count ? a.id : b.id),
                           w->material_count);
    memset(out, 0, sizeof *out);
    out->seconds = w->clock.time - w->events.n.since;
    for (k = 0; k <= DEM_IMPACT_BINS; k++) out->bin[k] = demi_impact_limit(k);
    for (i = 0; i < w->events.n.pairs; i++) {
        const demi_impacts *p = &w->events.pairs[i];
        if (!demi_impacts_fit(p->a, p->b, a, b)) continue;
        out->ended += p->ended;
        out->lost_normal += p->lost[0];
        out->lost_slide += p->lost[1];
        out->lost_tangent += p->lost[2];
        out->lost_rolling += p->lost[3];
        for (k = 0; k < DEM_IMPACT_BINS; k++) {
            out->impacts[k] += p->impacts[k];
            out->losses[k] += p->losses[k];
            out->energy[k] += p->energy[k];
        }
    }
    for (i = 0; i < w->events.n.open; i++) {
        const dem_event e = demi_event_shown(w, i, DEM_EVENT_OPEN);
        if (!demi_impacts_fit((int)e.material_a.id - 1, (int)e.material_b.id - 1, a, b)) continue;
        out->open++;
        out->lost_normal += e.lost_normal;
        out->lost_slide += e.lost_slide;
        out->lost_tangent += e.lost_tangent;
        out->lost_rolling += e.lost_rolling;
    }
    out->rate = out->seconds > 0 ? out->ended/out->seconds : 0;
    return DEM_OK;
}

/* Returns the wear of a wall; null if nothing has been recorded on it. Fails, with *result, if
   there is no such wall or no recording. */
static const demi_worn *demi_worn_of(dem_world *w, const char *call, dem_wall wall,
                                     dem_result *result) {
    const int i = demi_wall_place(wall);
    *result = demi_events_needed(w, call);
    if (*result != DEM_OK) return 0;
    if (!demi_wall_there(w, wall)) {
        *result = demi_fail(w, DEM_ERROR_ARGUMENT, "%s: wall %d does not exist; it was removed, or "
                            "the id belongs to another world", call, (int)wall.id);
        return 0;
    }
    return i < w->events.n.walls && w->events.walls[i].id == wall.id ? &w->events.walls[i] : 0;
}
DEM_API dem_result dem_wall_wear_get(dem_world *w, dem_wall wall, double coefficient,
                                     double hardness, dem_wear *wear) {
    const demi_worn *worn;
    dem_result result;
    if (demi_null_look(w, __func__, wear, "wear")) return DEM_ERROR_ARGUMENT;
    worn = demi_worn_of(w, __func__, wall, &result);
    if (result != DEM_OK) return result;
    if (!demi_finite_double(coefficient) || coefficient < 0 || !demi_finite_double(hardness) ||
        !(hardness > 0))
        return demi_refuse(w, __func__, "coefficient is %g, must be >= 0, and hardness is %g Pa, "
                           "must be > 0, both finite; steel has about 1e-4 and 2e9 Pa", coefficient,
                           hardness);
    memset(wear, 0, sizeof *wear);
    wear->seconds = w->clock.time - w->events.n.since;
    wear->slide = worn ? worn->slide : 0;
    wear->normal = worn ? worn->normal : 0;
    wear->volume = coefficient*wear->slide/hardness;
    return DEM_OK;
}
DEM_API int dem_wall_wear_facets_get(dem_world *w, dem_wall wall, double *work, int capacity) {
    const demi_worn *worn;
    dem_result result;
    int k, count;
    if (demi_null_look(w, __func__, w, "world")) return -1;
    worn = demi_worn_of(w, __func__, wall, &result);
    if (result != DEM_OK) return -1;
    k = demi_wall_place(wall);
    count = demi_wall_kinds[w->walls[k].kind].corners > 1 ? w->walls[k].element_count : 0;
    for (k = 0; k < count && k < capacity && work; k++)
        work[k] = worn ? w->events.facets[worn->first + k] : 0;
    return count;
}
