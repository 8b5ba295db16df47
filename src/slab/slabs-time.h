/* ---------------------------------------------------------------------------------------------
   >>slabs-time
   One time step for all slabs, as >>advice finds it for one world: chosen, or refused, by what all
   of them hold together, before anything moves.
   --------------------------------------------------------------------------------------------- */

/* The head stands in for the whole scene when a time step is chosen: of each material the smallest
   grains that move and the largest that does not; all at the highest speed, and two of them at the
   ends of the fall there is. */
static dem_result demi_slabs_stand_in(dem_slabs *s) {
    dem_world *h = &s->head;
    const dem_real g = demi_length(h->desc.gravity);
    const dem_vec3 down = g > 0 ? demi_unit(h->desc.gravity) : demi_v(0, 0, 0);
    const int m = h->material_count;
    double *v = s->values, many[DEMI_MATERIALS];
    dem_result result;
    int k, i, j;
    for (i = 0; i < 2*m; i++) v[i] = i < m ? -1e300 : 0;       /* minus smallest; largest fixed */
    v[2*m] = v[2*m + 3] = v[2*m + 4] = 0;       /* speed; lowest, highest; spin; of what moves */
    v[2*m + 1] = v[2*m + 2] = -1e300;
    memset(many, 0, sizeof many);
    for (k = 0; k < s->local; k++) {
        const dem_world *w = s->slabs[k].world;
        for (i = 0; i < w->bodies.count; i++) {
            const double x = (double)demi_dot(demi_at(w->bodies.pos + 4*i), down);
            const double r = (double)w->bodies.pos[4*i + 3];
            double speed;
            if (demi_is_ghost(w, i)) continue;
            j = w->bodies.material[i] - 1;
            speed = (double)demi_length(demi_at(w->bodies.vel + 4*i));
            if (w->bodies.inv_mass[i] > 0) {
                v[j] = DEMI_MAX(v[j], -demi_advise_radius(w, i));
                v[2*m + 4] = DEMI_MAX(v[2*m + 4], speed);
                many[j]++;
            } else v[m + j] = DEMI_MAX(v[m + j], demi_advise_radius(w, i));
            v[2*m] = DEMI_MAX(v[2*m], speed);
            v[2*m + 1] = DEMI_MAX(v[2*m + 1], r - x);
            v[2*m + 2] = DEMI_MAX(v[2*m + 2], r + x);
            if (demi_shape_of(w, i))
                v[2*m + 3] = DEMI_MAX(v[2*m + 3],
                                      (double)demi_length(demi_at(w->bodies.spin + 4*i)));
        }
    }
    result = demi_slabs_reduce(s, v, 2*m + 5, 0);
    h->clock.spin_elsewhere = v[2*m + 3];
    h->booked.speed_max = v[2*m + 4];
    if (result == DEM_OK) result = demi_slabs_reduce(s, many, m, 1);
    h->bodies.count = 0;
    for (j = 0; j < m && result == DEM_OK; j++)
        for (k = 0; k < 3; k++) {
            const double r = k < 2 ? -v[j] : v[m + j];
            const double at = h->bodies.count == 0 ? r - v[2*m + 1] : v[2*m + 2] - r;
            if (k < 2 ? many[j] <= k : !(r > 0)) continue;
            i = h->bodies.count++;
            demi_put(h->bodies.pos + 4*i, demi_scale(down, (dem_real)at));
            h->bodies.pos[4*i + 3] = (dem_real)r;
            demi_put(h->bodies.vel + 4*i, demi_v((dem_real)v[2*m], 0, 0));
            h->bodies.inv_mass[i] = k < 2 ? DEM_R(1) : DEM_R(0);
            h->bodies.material[i] = j + 1;
        }
    return result;
}
/* The time step of all: one slab asks itself, more are stood in for by the head. */
static dem_result demi_slabs_settle(dem_slabs *s) {
    dem_world *h = &s->head, *w = s->slabs[0].world;
    const dem_real before = h->clock.dt;
    dem_result result;
    int k;
    if (h->stage.dt_valid) return DEM_OK;
    if (s->count == 1) {
        w->stage.dt_valid = 0;
        result = demi_dt_settle(w);
        memcpy(h->error, w->error, sizeof h->error);
        h->clock.dt = w->clock.dt;
        h->clock.held = w->clock.held;
        h->stage.dt_valid = w->stage.dt_valid;
        h->clock.assumed_speed = w->clock.assumed_speed;
        h->stage.primed = w->stage.primed;
        return result;
    }
    demi_slabs_phase(s, demi_slab_finish);
    result = demi_slabs_stand_in(s);
    h->walls = w->walls;
    if (result == DEM_OK) result = demi_dt_settle(h);
    h->walls = 0;
    if (h->clock.dt < before || h->clock.dt > before) h->stage.primed = 0;
    for (k = 0; k < s->local; k++) {
        s->slabs[k].world->clock.dt = h->clock.dt;
        s->slabs[k].world->clock.assumed_speed = h->clock.assumed_speed;
        s->slabs[k].world->stage.dt_valid = 1;
    }
    return result;
}

/* --- as demi_dt_check: a body's contacts are known to its own slab and, across the border, to the
       one above, which sends what it knows of its ghosts down. First the cheap bounds; matrices
       only where those are not enough. --- */

/* The step that is asked about: the given one, twice one that was chosen, s. */
static double demi_slabs_press_most(const dem_slabs *s) {
    return (double)s->head.clock.dt*(s->head.desc.dt > 0 ? 1 : 2);
}
/* Room for `one` bytes of each ghost in the lower outbox, and of what comes from above. */
static int demi_slab_press_room(demi_slab *b, size_t one) {
    dem_world *w = b->world;
    if (!DEMI_GROW(w, b->out[0].bytes, (size_t)b->ghost_count*one) ||
        !DEMI_GROW(w, b->in[1].bytes, (size_t)b->lent_count*one)) return 0;
    b->out[0].size = (size_t)b->ghost_count*one;
    b->in[1].size = (size_t)b->lent_count*one;
    return 1;
}
static void demi_slab_press(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    const size_t n = (size_t)w->bodies.count;
    int k;
    (void)s;
    if (!DEMI_GROW(w, w->press, n) || !demi_slab_press_room(b, sizeof *w->press)) {
        b->result = demi_no_memory(w, "dem_slabs_step");
        return;
    }
    if (n) memset(w->press, 0, n*sizeof *w->press);
    demi_press_visit(w, w->press, 0);
    demi_press_rates(w, w->press);
    for (k = 0; k < b->ghost_count; k++)
        memcpy(b->out[0].bytes + (size_t)k*sizeof *w->press, w->press + b->ghost[k],
               sizeof *w->press);
}
/* Adds what comes from above: a bound of the step, from below. */
static void demi_slab_press_take(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    const char *from = b->lent_count ? demi_slab_inbox(s, b, 1)->bytes : 0;
    demi_press told;
    int i, k;
    for (k = 0; k < b->lent_count; k++) {
        demi_press *sum = w->press + b->lent[k];
        demi_unpack(&from, &told, sizeof told);
        sum->omega2 += told.omega2;
        sum->rate += told.rate;
        sum->contacts += told.contacts;
        sum->relax += told.relax;
        sum->deepest = DEMI_MAX(sum->deepest, told.deepest);
    }
    b->press_limit = 1e300;
    for (i = 0; i < w->bodies.count; i++)
        if (!demi_is_ghost(w, i))
            b->press_limit = demi_press_rate_step(w->press + i, DEMI_MIN(
                b->press_limit, demi_dt_stable(w->press[i].omega2, w->press[i].rate)));
}
static void demi_slab_press_whole(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    const size_t n = (size_t)w->bodies.count, one = sizeof *w->press_whole;
    int i, k;
    (void)s;
    if (!DEMI_GROW(w, w->press_whole, n) || !demi_slab_press_room(b, one)) {
        b->result = demi_no_memory(w, "dem_slabs_step");
        return;
    }
    if (n) memset(w->press_whole, 0, n*one);
    for (i = 0; i < w->bodies.count; i++) w->press[i].whole = i + 1;
    demi_press_visit(w, w->press, w->press_whole);
    for (k = 0; k < b->ghost_count; k++)
        memcpy(b->out[0].bytes + (size_t)k*one, w->press_whole + b->ghost[k], one);
}
static void demi_slab_press_limit(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    const char *from = b->lent_count ? demi_slab_inbox(s, b, 1)->bytes : 0;
    demi_press_whole told;
    int i, k;
    for (k = 0; k < b->lent_count; k++) {
        double *to = (double *)(void *)(w->press_whole + b->lent[k]);
        const double *add = (const double *)(const void *)&told;
        demi_unpack(&from, &told, sizeof told);
        for (i = 0; i < (int)(sizeof told/sizeof *to); i++) to[i] += add[i];
    }
    b->press_limit = demi_slabs_press_most(s);
    for (i = 0; i < w->bodies.count; i++) {
        const double limit = demi_is_ghost(w, i) ? b->press_limit
            : demi_press_step(w->press_whole + i,
                              demi_press_rate_step(w->press + i, demi_slabs_press_most(s)));
        if (limit < b->press_limit) { b->press_limit = limit; b->press_worst = i; }
    }
}
/* Lets all slabs say what they know of ghosts and take what is told of their own, then agree on the
   smallest limit. Outboxes are then as long again as steps need them. */
static dem_result demi_slabs_press_ask(dem_slabs *s, void (*say)(dem_slabs *, demi_slab *),
                                       void (*take)(dem_slabs *, demi_slab *), double *limit) {
    double most = -1e300;                       /* less the limit: maxima are what is agreed on */
    dem_result result;
    int k;
    demi_slabs_phase(s, say);
    result = demi_slabs_agree(s, 0, 0);
    if (result == DEM_OK) result = demi_slabs_exchange(s, DEMI_DOWN, 1);
    if (result == DEM_OK) demi_slabs_phase(s, take);
    demi_slabs_phase(s, demi_slab_sizes);
    if (result != DEM_OK) return result;
    for (k = 0; k < s->local; k++) most = DEMI_MAX(most, -s->slabs[k].press_limit);
    result = demi_slabs_agree(s, &most, 1);
    *limit = -most;
    return result;
}
static dem_result demi_slabs_press(dem_slabs *s) {
    dem_world *h = &s->head;
    const int chosen = !(h->desc.dt > 0);
    const double dt = demi_slabs_press_most(s);
    double limit = 0;
    dem_result result;
    int k;
    result = demi_slabs_press_ask(s, demi_slab_press, demi_slab_press_take, &limit);
    if (result == DEM_OK && limit < dt)
        result = demi_slabs_press_ask(s, demi_slab_press_whole, demi_slab_press_limit, &limit);
    if (result != DEM_OK) return result;
    demi_press_looked(&h->clock, h);
    if (limit >= dt) return DEM_OK;
    for (k = 0; k < s->local; k++) {
        demi_slab *b = &s->slabs[k];
        if (chosen && limit/2 >= DEMI_DT_LEAST) b->world->clock.dt = (dem_real)(limit/2);
        else if (chosen) continue;
        else if (!(b->press_limit > limit))
            b->result = demi_press_refuse(b->world, limit, b->press_worst);
    }
    if (!chosen) return demi_slabs_agree(s, 0, 0);
    if (!(limit/2 >= DEMI_DT_LEAST))
        return demi_dt_refuse(h, limit/2, "contacts that press a body");
    demi_slabs_phase(s, demi_slab_finish);
    h->clock.dt = (dem_real)(limit/2);
    h->clock.held.by = DEMI_HELD_PRESSED;
    h->clock.held.limit = limit;
    h->clock.held.body = 0;
    h->stage.primed = 0;
    return DEM_OK;
}
static dem_result demi_slabs_dt_check(dem_slabs *s) {
    dem_world *h = &s->head, *w = s->slabs[0].world;
    dem_result result;
    if (h->desc.allow_large_dt) return DEM_OK;
    if (s->count == 1) {
        result = demi_dt_check(w);
        memcpy(h->error, w->error, sizeof h->error);
        h->clock.dt = w->clock.dt;
        h->clock.held = w->clock.held;
        h->stage.primed = h->stage.primed && w->stage.primed;
        return result;
    }
    result = demi_speed_check(h, h->booked.speed_max + w->margin.last_change, 0);
    if (result == DEM_OK) {
        result = demi_wall_speed_check(w, (double)h->effects.radius_min, (double)h->clock.dt);
        if (result != DEM_OK) memcpy(h->error, w->error, sizeof h->error);
    }
    return result != DEM_OK || h->clock.steps < h->clock.press_due ? result : demi_slabs_press(s);
}
