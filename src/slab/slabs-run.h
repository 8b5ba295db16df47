/* ---------------------------------------------------------------------------------------------
   >>slabs-run
   Feeds of slabs, and dem_slabs_step. The head owns the feeds and draws new grains, the same in
   every process. Each slab tests its bodies for overlaps with a new grain. The slab between whose
   borders the grain is then inserts it. The grain gets a slot that was never used. All lists are
   rebuilt before the step. Forces stay valid, because a new grain touches nothing, unless there are
   force fields or the law has a range.
   --------------------------------------------------------------------------------------------- */

/* Reserves memory for one more body and for one more slot: slot numbers are those of the whole
   scene, so every slab has all slots. Returns 0 if memory ran out. */
static int demi_slab_widen(demi_slab *b, int slot) {
    dem_world *w = b->world;
    return demi_bodies_reserve(w, (size_t)w->bodies.count + 1) &&
           DEMI_GROW(w, w->bodies.ghost, (size_t)slot + 2);
}
/* `look` of demi_feeder: each slab collects its bodies near a feed's region. Distances are those of
   the whole scene, which may be periodic along the axis where a slab is not. */
static dem_result demi_slabs_look(void *who, const demi_region *g, dem_real radius) {
    dem_slabs *s = (dem_slabs *)who;
    int k;
    if (!s->head.stage.primed) demi_slabs_all(&s->head, demi_member_finish);
    for (k = 0; k < s->local; k++) {
        demi_slab *b = &s->slabs[k];
        if (!demi_crowd_begin(b->world, &b->crowd, g, radius, 0, demi_periods_of(&s->head)))
            b->result = demi_no_memory(b->world, "dem_slabs_step");
    }
    return demi_slabs_agree(&s->head, 0, 0);
}
/* Reserves memory in all slabs for a grain of radius r (m) at x, and for its slot. owner: the slab
   that will insert it; null if another process holds that slab. */
static dem_result demi_slabs_feed_room(dem_slabs *s, demi_slab *owner, dem_vec3 x, dem_real r) {
    int k;
    for (k = 0; k < s->local; k++)
        if (!demi_slab_widen(&s->slabs[k], s->slots))
            s->slabs[k].result = demi_no_memory(s->slabs[k].world, "dem_slabs_step");
    if (!DEMI_GROW(&s->head, s->known, (size_t)s->slots + 2))
        s->slabs[0].result = demi_no_memory(s->slabs[0].world, "dem_slabs_step");
    if (owner && owner->result == DEM_OK &&
        (!demi_crowd_put(owner->world, &owner->crowd, x, r, owner->world->bodies.count) ||
         !demi_list_drop(owner->world)))
        owner->result = demi_no_memory(owner->world, "dem_slabs_step");
    return demi_slabs_agree(&s->head, 0, 0);
}
/* `put` of demi_feeder. Draws all positions that may be tried and tests them in all processes with
   a single reduction. Takes the first free one, as a single world does, which tries one after the
   other; the random numbers of the others are not used up. */
static int demi_slabs_put(void *who, demi_feed *f, const demi_region *g) {
    dem_slabs *s = (dem_slabs *)who;
    dem_world *h = &s->head;
    const dem_real r = f->drawn.reach;
    const demi_periods p = demi_periods_of(h);
    const uint64_t random = f->random;
    uint64_t after[DEMI_FEED_TRIES];
    double taken[DEMI_FEED_TRIES], at[3];
    dem_vec3 x[DEMI_FEED_TRIES], v[DEMI_FEED_TRIES];
    demi_slab *owner = 0;
    dem_result result;
    const int m = demi_feed_material(&f->desc, (int)f->next);
    int n, k;
    for (n = 0; n < DEMI_FEED_TRIES; n++) {
        taken[n] = !demi_feed_try(h, f, g, &x[n], &v[n]) ||
                   !demi_walls_clear(s->slabs[0].world, m, demi_place_of(&p, x[n]), r);
        after[n] = f->random;
        for (k = 0; k < s->local; k++) s->slabs[k].crowd.material = m;
        for (k = 0; k < s->local && !(taken[n] > 0); k++)
            taken[n] = !demi_crowd_free(s->slabs[k].world, &s->slabs[k].crowd, x[n], r);
    }
    result = demi_slabs_reduce(s, taken, DEMI_FEED_TRIES, 0);
    for (n = 0; n < DEMI_FEED_TRIES && taken[n] > 0; n++) continue;
    if (result == DEM_OK && n == DEMI_FEED_TRIES) return 0;
    if (result == DEM_OK) {
        x[n] = demi_place_of(&p, x[n]);
        at[0] = (double)x[n].x; at[1] = (double)x[n].y; at[2] = (double)x[n].z;
        for (k = 0; k < s->local; k++)
            if ((s->slabs[k].index == 0 || at[s->axis] >= s->borders[s->slabs[k].index]) &&
                (s->slabs[k].index == s->count - 1 ||
                 at[s->axis] < s->borders[s->slabs[k].index + 1])) owner = &s->slabs[k];
        demi_list_outdated(h);
        result = demi_slabs_feed_room(s, owner, x[n], r);
    }
    if (result != DEM_OK) { f->random = random; return -(int)result; }
    f->random = after[n];
    for (k = 0; k < s->local; k++) {
        demi_bodies *bodies = &s->slabs[k].world->bodies;
        const int rest = bodies->slot_free;
        bodies->slot_free = -1;                 /* take the next slot that was never used */
        bodies->slot_index[s->slots] = -1;
        bodies->slot_generation[s->slots] = 1;
        bodies->ghost[s->slots] = 0;
        bodies->slot_count = s->slots + (&s->slabs[k] != owner);
        if (&s->slabs[k] == owner) {
            const int i = demi_feed_append(owner->world, f, x[n], v[n]);
            if (h->stage.primed) demi_prime_body(owner->world, i);
        }
        bodies->slot_free = rest;
    }
    s->known[s->slots++] = 1;
    h->bodies.balance.inserted++;
    demi_speed_book(h, (double)demi_length(v[n]));
    /* forces may act on it */
    if (h->desc.force || h->desc.body_force || demi_reach_of(h, 1) > 0) demi_scene_changed(h);
    demi_feed_count(f);
    return 1;
}
/* Inserts all grains that are due before a step. */
static dem_result demi_slabs_feed(dem_world *h) {
    const demi_feeder feeder = {demi_slabs_look, demi_slabs_put, h};
    return demi_feeds_run(h, &feeder);
}

/* Fails if the transport has failed before. */
static dem_result demi_slabs_usable(dem_slabs *s, const char *call) {
    if (!s->broken) return DEM_OK;
    return demi_fail(&s->head, DEM_ERROR_STOPPED, "%s: the transport failed earlier, so slabs may "
                     "be out of step; create them again from the last collected world or "
                     "checkpoint", call);
}
DEM_API dem_result dem_slabs_step(dem_slabs *s, int steps) {
    if (!s || demi_null(&s->head, __func__, s, "slabs")) return DEM_ERROR_ARGUMENT;
    const dem_result result = demi_slabs_usable(s, __func__);
    if (result != DEM_OK) return result;
    if (steps < 0)
        return demi_refuse(&s->head, __func__, "steps is %d, must be >= 0", steps);
    return demi_steps(&s->head, __func__, steps);
}
