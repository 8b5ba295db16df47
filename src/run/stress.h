/* ---------------------------------------------------------------------------------------------
   >>stress
   Stress and fabric of the whole domain, and how a periodic cell that deforms (>>cell) follows
   strain rates or target stresses. Owns w->cell; moves the domain of the desc.

   The law of the stress. Along an axis let K and C be the sums of stiffness and damping over all
   contacts for a strain of that axis (demi_cell_stiffen) over the volume, T the target, S the
   stress, v and u the compression rates of the coming and the last step:
       K dt (v - b u) + C (v - u) = a (T - S),   |v| at most the largest rate,
   with a and b of servo walls (>>servo), where gain and stability are derived: K is the response of
   the stress to a strain before any grain has moved on its own. K and C are renewed every eighth
   step (DEMI_CELL_REST). K leaves out friction, which raises the response by at most two thirds,
   and the other axes, which together with this one raise that of the pressure by as much. The limit
   of the gain is seven times as high.
   --------------------------------------------------------------------------------------------- */
/* Volume of the domain, m3. */
static double demi_volume(const dem_world *w) {
    double lo[3], hi[3];
    demi_domain_limits(w, lo, hi);
    return (hi[0] - lo[0])*(hi[1] - lo[1])*
        (w->desc.planar ? (double)w->desc.thickness : hi[2] - lo[2]);
}
/* Fails and returns 1 if the scene contains what cannot follow the cell. */
static int demi_cell_refuse(dem_world *w, const char *call) {
    int count[DEMI_CELL_PARTS], k;
    memset(count, 0, sizeof count);
    for (k = 0; k < w->wall_count; k++)
        count[DEMI_CELL_WALLS] += w->walls[k].kind != DEMI_WALL_NONE;
    count[DEMI_CELL_RAILS] = demi_rails_in_force(w);
    count[DEMI_CELL_FEEDS] = w->feed_count;
    count[DEMI_CELL_OUTLETS] = w->outlet_count;
    count[DEMI_CELL_FIELDS] = demi_cell_slides(w) ? w->field_count : 0;
    for (k = 0; k < DEMI_CELL_PARTS; k++) if (count[k]) return demi_cell_bars(w, call, k);
    return 0;
}
/* Chooses the strain rate of axis k for the coming step, from the sums over work groups. */
static double demi_cell_choose(dem_world *w, int k, double target, double most) {
    demi_strained *c = &w->cell;
    const double dt = (double)w->clock.dt, was = -c->rate[k];
    const double push = DEMI_SERVO_GAIN*(target - c->stress[k]) +
        (DEMI_SERVO_KEPT*c->stiffness[k]*dt + c->damping[k])*was;
    const double gives = c->stiffness[k]*dt + c->damping[k];
    return -(fabs(push) < most*gives ? push/gives : push > 0 ? most : push < 0 ? -most : 0);
}
/* Measures the stress that the cell sees, and its stiffness and damping. */
static void demi_cell_look(dem_world *w) {
    demi_strained *c = &w->cell;
    const double volume = demi_volume(w);
    const int fresh = demi_cell_stiffens(w);
    int d, k;
    for (k = 0; k < 3; k++) {
        c->stress[k] = 0;
        if (fresh) c->stiffness[k] = c->damping[k] = 0;
        for (d = 0; d < w->domain_count; d++) {
            const double *sum = w->domains[d].cell;
            c->stress[k] += (sum[DEMI_CELL_FLUX + k] - sum[DEMI_CELL_VIRIAL + 4*k])/volume;
            c->stiffness[k] += sum[DEMI_CELL_STIFF + k]/volume;
            c->damping[k] += sum[DEMI_CELL_DAMP + k]/volume;
        }
    }
}
/* Chooses the rates for the coming step along the axes that are led to a stress. */
static dem_result demi_cell_lead(dem_world *w) {
    demi_strained *c = &w->cell;
    dem_real stress[3], most[3];
    double rate[3], drag[3], norm = fabs(c->shear), dt = (double)w->clock.dt;
    int k;
    if (demi_cell_refuse(w, "dem_world_step")) return DEM_ERROR_ARGUMENT;
    demi_put(stress, c->desc.stress);
    demi_put(most, c->desc.rate_most);
    demi_cell_look(w);
    for (k = 0; k < 3; k++) {
        rate[k] = most[k] > 0 ? demi_cell_choose(w, k, (double)stress[k], (double)most[k])
            : c->rate[k];
        norm = DEMI_MAX(norm, fabs(rate[k]) + fabs(c->shear));
    }
    memcpy(drag, c->rate, sizeof drag);
    memcpy(c->rate, rate, sizeof rate);
    if (!(norm*dt <= 0.01))
        return demi_fail(w, DEM_ERROR_TIME_STEP, "dem_world_step: step %llu: the cell is deformed "
                         "at %g 1/s, which strains it by %g in a step of %g s, must be at most "
                         "0.01; use lower rates (rate, shear, rate_most)",
                         (unsigned long long)w->clock.steps, norm, norm*dt, dt);
    if (w->desc.ledger) demi_cell_book(w, drag);
    c->squeeze = norm*dt*(1 + norm*dt/2)*(2*(double)w->effects.radius_max + (double)demi_cover(w));
    return DEM_OK;
}
/* Moves the sides of the cell for one step, and all images. */
static void demi_cell_move(dem_world *w) {
    demi_strained *c = &w->cell;
    double by[3], shear = demi_cell_map(w, by);
    dem_real lo[3], hi[3];
    int k;
    demi_put(lo, w->desc.domain.lo);
    demi_put(hi, w->desc.domain.hi);
    c->offset += by[0]*c->offset + shear*c->side[1];
    c->sheared += c->shear*(double)w->clock.dt;
    for (k = 0; k < 3; k++) {
        c->side[k] += by[k]*c->side[k];
        c->strain[k] += log1p(by[k]);
        if (w->desc.boundary[k] != DEM_BOUNDARY_PERIODIC) continue;
        lo[k] = (dem_real)(c->mid[k] - c->side[k]/2);
        hi[k] = (dem_real)(c->mid[k] + c->side[k]/2);
    }
    w->desc.domain.lo = demi_at(lo);
    w->desc.domain.hi = demi_at(hi);
    demi_image_shifts(w);
}
#define DEMI_CELL(field, type, how, unit) \
    DEMI_LIMITED(dem_cell_desc, field, type, how, DEMI_FARTHEST, unit)
static const demi_field_row demi_cell_rows[] = {DEMI_CELL(rate, 'v', DEMI_ANY, "1/s"),
    DEMI_CELL(shear, 'r', DEMI_ANY, "1/s"), DEMI_CELL(stress, 'v', DEMI_ANY, "Pa"),
    DEMI_CELL(rate_most, 'v', DEMI_FROM, "1/s"), DEMI_ROW_END};
/* Checks the rates of each axis of a desc; *moves receives 1 if any is not 0. */
static dem_result demi_cell_axes(dem_world *w, const char *call, const dem_cell_desc *d,
                                 int *moves) {
    dem_real rate[3], most[3];
    int k;
    demi_put(rate, d->rate);
    demi_put(most, d->rate_most);
    for (k = 0; k < 3; k++) {
        const int rated = rate[k] < 0 || rate[k] > 0, led = most[k] > 0;
        const int sheared = k < 2 && (d->shear < 0 || d->shear > 0);
        *moves |= rated || led || sheared;
        if (rated && led)
            return demi_refuse(w, call, "axis %d has the strain rate %g 1/s and the largest rate "
                               "%g 1/s towards a stress, one of them must be 0", k, (double)rate[k],
                               (double)most[k]);
        if ((rated || led || sheared) && w->desc.boundary[k] != DEM_BOUNDARY_PERIODIC)
            return demi_refuse(w, call, "axis %d is to be %s, but its boundary is not periodic; "
                               "set desc.boundary[%d] to DEM_BOUNDARY_PERIODIC, or move walls "
                               "instead", k, rated || led ? "strained" : "sheared", k);
    }
    return DEM_OK;
}
DEM_API dem_result dem_cell_set(dem_world *w, const dem_cell_desc *desc) {
    demi_strained *c;
    dem_cell_desc before;
    dem_real rate[3], most[3];
    double lo[3], hi[3];
    int k, moves = 0;
    if (demi_null(w, __func__, desc, "desc") ||
        demi_rows_check(w, __func__, demi_cell_rows, desc, "", "start from DEM_CELL_DESC and set "
                        "only what differs")) return DEM_ERROR_ARGUMENT;
    c = &w->cell;
    if (!demi_response_is(w, DEMI_LAWS))
        return demi_refuse(w, __func__, "contacts of this world are impulses, whose solvers do not "
                           "see the flow of a cell; use DEM_RESPONSE_SPRINGS");
    if (w->team)
        return demi_refuse(w, __func__, "this world is a slab, and borders of slabs do not move; "
                           "use threads");
    if (demi_cell_axes(w, __func__, desc, &moves) != DEM_OK) return DEM_ERROR_ARGUMENT;
    before = c->desc;
    c->desc = *desc;
    if (moves && demi_cell_refuse(w, __func__)) { c->desc = before; return DEM_ERROR_ARGUMENT; }
    if (!moves && !c->on) return DEM_OK;
    if (!c->on) {
        demi_domain_limits(w, lo, hi);
        for (k = 0; k < 3; k++) { c->mid[k] = (lo[k] + hi[k])/2; c->side[k] = hi[k] - lo[k]; }
    }
    c->on = moves || demi_cell_slid(w);
    demi_finish(w);                             /* the open half kick belongs to the old rates */
    demi_put(rate, desc->rate);
    demi_put(most, desc->rate_most);
    for (k = 0; k < 3; k++) if (!(most[k] > 0)) c->rate[k] = (double)rate[k];
    c->shear = (double)desc->shear;
    if (!c->on) c->squeeze = 0;
    demi_scene_changed(w);
    return DEM_OK;
}
DEM_API dem_result dem_cell_state_get(const dem_world *w, dem_cell_state *out) {
    if (demi_null_look(w, __func__, out, "state")) return DEM_ERROR_ARGUMENT;
    memset(out, 0, sizeof *out);
    out->box = w->desc.domain;
    out->offset = (dem_real)w->cell.offset;
    memcpy(out->strain, w->cell.strain, sizeof out->strain);
    memcpy(out->rate, w->cell.rate, sizeof out->rate);
    memcpy(out->stress, w->cell.stress, sizeof out->stress);
    out->shear = w->cell.sheared;
    out->shear_rate = w->cell.shear;
    return DEM_OK;
}

/* Adds a contact: its symmetric virial, and the fabric of two bodies. */
static void demi_stress_add(dem_stress *s, const demi_walk *c) {
    const dem_contact_info *i = &c->info;
    const double f[3] = {(double)i->force.x, (double)i->force.y, (double)i->force.z};
    const double l[3] = {(double)c->branch.x, (double)c->branch.y, (double)c->branch.z};
    const double n[3] = {(double)i->normal.x, (double)i->normal.y, (double)i->normal.z};
    int k;
    for (k = 0; k < 6; k++) {
        const int x = k < 3 ? k : k > 4, y = k < 3 ? k : k == 3 ? 1 : 2;
        s->contact[k] -= (f[x]*l[y] + f[y]*l[x])/2/s->volume;
        if (c->b >= 0 && c->counts) s->fabric[k] += n[x]*n[y];
    }
    if (!c->counts) return;
    s->contacts += c->b >= 0;
    s->coordination += c->b < 0 ? 1 : 2;
}
/* Adds the kinetic stress and the solid fraction. */
static void demi_stress_move(const dem_world *w, dem_stress *s) {
    double mass = 0, mean[3] = {0, 0, 0};
    int i, k;
    for (i = 0; i < w->bodies.count; i++) {
        const double m = (double)w->bodies.mass[i];
        const dem_real *v = w->bodies.vel + 4*i;
        s->solid += m/(double)w->materials[w->bodies.material[i] - 1].density/s->volume;
        if (w->bodies.inv_mass[i] <= 0) continue;
        mass += m;
        for (k = 0; k < 3; k++) mean[k] += m*(double)v[k];
        for (k = 0; k < 6; k++)
            s->kinetic[k] += m*(double)v[k < 3 ? k : k > 4]*
                (double)v[k < 3 ? k : k == 3 ? 1 : 2]/s->volume;
    }
    for (k = 0; k < 6 && mass > 0; k++)
        s->kinetic[k] -= mean[k < 3 ? k : k > 4]*mean[k < 3 ? k : k == 3 ? 1 : 2]/mass/s->volume;
}
DEM_API dem_result dem_stress_get(const dem_world *w, dem_stress *s) {
    demi_walk c = demi_walk_begin();
    int k;
    if (demi_null_look(w, __func__, s, "stress")) return DEM_ERROR_ARGUMENT;
    memset(s, 0, sizeof *s);
    if (!demi_contacts_known(w) && demi_list_stale(w, __func__)) return DEM_ERROR_ARGUMENT;
    s->volume = demi_volume(w);
    if (!(s->volume > 0)) {
        s->volume = 0;
        return demi_refuse(w, __func__, "the domain has the volume 0; set desc.domain "
                           "along all axes");
    }
    while (demi_walk_next(w, &c)) demi_stress_add(s, &c);
    demi_stress_move(w, s);
    for (k = 0; k < 6; k++) {
        s->total[k] = s->contact[k] + s->kinetic[k];
        if (s->contacts) s->fabric[k] /= s->contacts;
    }
    s->coordination /= DEMI_MAX(w->bodies.count, 1);
    return DEM_OK;
}
static int demi_cell_on(const dem_world *h) { return h->cell.on; }
static dem_result demi_cell_whole(dem_world *w, const char *call) {
    if (!w->cell.on && !(w->cell.side[0] > 0)) return DEM_OK;
    return demi_refuse(w, call, "the periodic cell of this world has been deformed "
                       "(dem_cell_set), but borders of slabs do not move; use threads");
}
