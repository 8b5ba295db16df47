/* ---------------------------------------------------------------------------------------------
   >>deal
   Creation of slabs from a world, and collection of their state into a world. The world of a slab
   has the materials, shapes, walls, fields and outlets of the scene, and slots for all bodies that
   exist; the slabs of one process share the geometry of the first. Creation checks that all
   processes have built the same scene. Collection first checks whether the world can take
   everything, then allocates, then writes: a call that fails leaves the world as it was. Writes to
   slabs, and in dem_slabs_collect to the world.
   --------------------------------------------------------------------------------------------- */

/* --- a user-defined allocator, as slabs on several threads call it: one call at a time --- */
static void *demi_slabs_alloc(size_t size, void *user) {
    const dem_allocator *a = (const dem_allocator *)user;
    void *p;
#if DEMI_OPENMP
    #pragma omp critical(demi_slabs)
#endif
    p = DEMI_USER_WITHIN(a->alloc_fn(size, a->user));
    return p;
}
static void demi_slabs_free(void *memory, size_t size, void *user) {
    const dem_allocator *a = (const dem_allocator *)user;
#if DEMI_OPENMP
    #pragma omp critical(demi_slabs)
#endif
    DEMI_USER_WITHIN(a->free_fn(memory, size, a->user));
}

/* Copies the walls of a scene. The first slab of a process gets its own geometry. Later slabs share
   it, and their walls have no motion. Returns 0 if memory ran out. */
static int demi_slab_walls(dem_world *to, const dem_world *from, const dem_world *first) {
    const size_t n = (size_t)from->wall_count;
    int i;
    to->walls = (demi_wall *)demi_hold(to, DEMI_RUN, n, sizeof *to->walls);
    if (!n) return 1;
    if (!to->walls) return 0;
    for (i = 0; i < from->wall_count; i++) {
        demi_wall *b = &to->walls[i];
        *b = first ? first->walls[i] : from->walls[i];
        if (!first && !demi_wall_own(to, b)) return 0;
        to->wall_count = i + 1;
    }
    return first ? demi_surfaces_share(to, first) : demi_surfaces_make(to);
}
/* Copies the shapes of a scene; slabs after the first share those of the first. Returns 0 if memory
   ran out. */
static int demi_slab_shapes(dem_world *to, const dem_world *from, const dem_world *first) {
    int i;
    if (first) {
        to->shapes = first->shapes;
        to->shape_count = first->shape_count;
        return 1;
    }
    for (i = 0; i < from->shape_count; i++) {
        demi_shape shape = from->shapes[i];
        if (!demi_shape_copy(to, &shape)) return 0;
        if (!demi_shape_adopt(to, "dem_slabs_create", &shape).id) return 0;
    }
    return 1;
}
/* Sets the sums over time to 0. Slab 0 starts with those of the world, the other slabs start at 0;
   collecting also starts at 0. booked: the uses (DEMI_SUM, ...) of the fields of demi_booked that
   are cleared. */
static void demi_slab_sums_clear(dem_world *w, int booked) {
    int i;
    demi_rows_clear(demi_booked_rows, &w->booked, booked);
    w->bodies.balance.left = 0;
    for (i = 0; i < w->wall_count; i++)
        demi_rows_clear(demi_loads_rows, &w->walls[i].loads, DEMI_SUM | DEMI_EITHER);
    for (i = 0; i < w->outlet_count; i++)
        demi_rows_clear(demi_outlet_state_rows, &demi_outlet_at(w, i)->state, DEMI_SUM);
}
/* Copies to a slab what each feature shares. Returns 0 if memory ran out. */
static int demi_slab_features(dem_world *slab, const dem_world *from, int first) {
    int row;
    for (row = 0; row < DEMI_FEATURES; row++)
        if (demi_features[row].share && !demi_features[row].share(slab, from, first)) return 0;
    return 1;
}
/* Creates the world of slab `index`: the whole scene without its grains. first: the world of the
   first slab of this process, null for that slab itself. *ok becomes 1; if memory ran out, it
   becomes 0, and the function returns null or an incomplete world. */
static dem_world *demi_slab_world(dem_slabs *s, const dem_world *from, int index,
                                  const dem_world *first, dem_allocator *allocator, int *ok) {
    dem_world_desc desc = from->asked;
    const size_t slots = (size_t)from->bodies.slot_count;
    dem_world *w;
    desc.threads = s->local == 1 ? from->desc.threads : 1;
    if (s->ring) desc.boundary[s->axis] = DEM_BOUNDARY_OPEN;
    if (desc.allocator.alloc_fn) {
        desc.allocator.alloc_fn = demi_slabs_alloc;
        desc.allocator.free_fn = demi_slabs_free;
        desc.allocator.user = allocator;
    }
    w = dem_world_create(&desc);
    *ok = 0;
    if (!w) return 0;
    w->look.of = &s->head;
    if (s->ring) w->ring_period[s->axis] = (dem_real)s->period;
    memcpy(w->materials, from->materials, sizeof w->materials);
    memcpy(w->pairs, from->pairs, (size_t)DEMI_MATERIALS*DEMI_MATERIALS*sizeof(demi_pair));
    w->material_count = from->material_count;
    w->feeds = s->head.feeds;
    w->feed_count = s->head.feed_count;
    w->bodies.ghost = (uint8_t *)demi_hold(w, DEMI_RUN, slots + 1, 1);
    w->bodies.slot_index = (int32_t *)demi_hold(w, DEMI_RUN, slots + 1, sizeof(int32_t));
    w->bodies.slot_generation = (uint32_t *)demi_hold(w, DEMI_RUN, slots + 1, sizeof(uint32_t));
    w->bodies.slot_capacity = (int)slots + 1;
    w->bodies.slot_count = (int)slots;
    if (!w->bodies.ghost || !w->bodies.slot_index || !w->bodies.slot_generation ||
        (from->bodies.orienting && !demi_orient_begin(w)) || !demi_slab_shapes(w, from, first) ||
        !demi_slab_walls(w, from, first) || !demi_slab_features(w, from, index == 0) ||
        !demi_flush_share(w, from)) return w;
    s->head.shapes = w->shapes;                 /* for the grains of feeds */
    s->head.shape_count = w->shape_count;
    memset(w->bodies.slot_index, 0xff, slots*sizeof(int32_t));
    if (slots) memcpy(w->bodies.slot_generation, from->bodies.slot_generation,
                      slots*sizeof(uint32_t));
    demi_rows_copy(demi_number_rows, w, from, DEMI_TO_SLAB);
    demi_rows_copy(demi_booked_rows, &w->booked, &from->booked, DEMI_TO_SLAB);
    w->clock.last_rebuild = from->clock.steps;
    /* the histories are those of these laws; the first list converts them to those in force then */
    w->laws = from->laws;
    w->effects.tangent = from->effects.tangent;
    w->effects.rolling = from->effects.rolling;
    w->effects.sticks = from->effects.sticks;
    w->effects.twisting = from->effects.twisting;
    w->memory_stride = from->memory_stride;     /* before its first list, too */
    w->stage.forces_valid = from->stage.forces_valid && !from->stage.pairs_changed;
    if (index > 0) demi_slab_sums_clear(w, DEMI_SUM);
    *ok = 1;
    return w;
}
/* Copies the grains between the borders of one slab from the world, with their contact histories.
   marks: work array, one per slot. Returns 0 if memory ran out. */
static int demi_slab_fill(dem_slabs *s, demi_slab *b, const dem_world *from, uint8_t *marks) {
    dem_world *w = b->world;
    const char *at;
    demi_message_head h;
    int i;
    for (i = 0; i < from->bodies.count; i++) {
        const double x = (double)from->bodies.pos[4*i + s->axis];
        marks[from->bodies.slot[i]] = (b->index == 0 || x >= s->borders[b->index]) &&
            (b->index == s->count - 1 || x < s->borders[b->index + 1]);
    }
    b->out[0].size = 0;
    if (!demi_pack(w, from, marks, 1, 1, s->axis, 0, &b->out[0])) return 0;
    at = b->out[0].bytes;
    demi_unpack(&at, &h, sizeof h);
    if (!demi_bodies_reserve(w, (size_t)h.grains) || !demi_filed_reserve(w, &b->add, &h)) return 0;
    for (i = 0; i < h.grains; i++) demi_grain_append(w, &at);
    demi_filed_unpack(w, b->add, &h, at);
    return 1;
}

/* Returns DEM_OK if slabs can be created from this world and desc; otherwise fails in the world. */
static dem_result demi_slabs_check(dem_world *w, const dem_slabs_desc *d) {
    const char *call = "dem_slabs_create";
    const int local = d->local ? d->local : d->count;
    int row;
    for (row = 0; row < DEMI_FEATURES; row++)
        if (demi_features[row].whole && demi_features[row].whole(w, call) != DEM_OK)
            return DEM_ERROR_ARGUMENT;
    if (!demi_response_is(w, DEMI_LAWS))
        return demi_refuse(w, call, "contacts of this world are impulses, which cannot be split "
                           "into slabs; use threads");
    if (d->axis < 0 || d->axis > 2 || (w->desc.planar && d->axis == 2))
        return demi_refuse(w, call, "axis is %d, must be 0, 1 or 2%s; choose the one along which "
                           "the scene is longest", d->axis,
                           w->desc.planar ? " (for discs, at z = 0, only 0 or 1)" : "");
    if (d->count < 1 || d->count > DEMI_SLABS)
        return demi_refuse(w, call, "count is %d, must be 1 to %d (required); one slab per "
                           "processor is a good choice", d->count, (int)DEMI_SLABS);
    if (d->first < 0 || local < 1 || d->first > d->count - local || (!d->local && d->first))
        return demi_refuse(w, call, "first and local give slabs %d to %.0f, must lie in 0 to %d; "
                           "set both, or leave both 0 for all slabs", d->first,
                           (double)d->first + local - 1, d->count - 1);
    if (!d->transport.exchange_fn != !d->transport.reduce_fn ||
        (local < d->count && !d->transport.exchange_fn))
        return demi_refuse(w, call, "this process holds %d of %d slabs, but the transport lacks "
                           "exchange_fn or reduce_fn; give both, or hold all slabs", local,
                           d->count);
    if (!demi_finite(d->balance) || (d->balance > 0 && d->balance < 1) || d->balance_interval < 0)
        return demi_refuse(w, call, "balance is %g and balance_interval is %d; balance must be 0, "
                           ">= 1 or < 0 (never), balance_interval >= 0", (double)d->balance,
                           d->balance_interval);
    if (w->events.n.on && local < d->count)
        return demi_refuse(w, call, "this process holds %d of %d slabs, but the world records "
                           "contacts, whose records cannot change processes; hold all slabs, or "
                           "call dem_events_stop first", local, d->count);
    if (w->stage.moved)
        return demi_refuse(w, call, "the world is in the middle of a step that ran out of memory; "
                           "finish the step with dem_world_step first");
    return DEM_OK;
}
/* Fails in all processes unless all hold the same scene, with bodies in the same order, all or none
   with a list, none ran out of memory, and together they hold every slab once. A digest is sent as
   two whole numbers of 32 bits, which doubles hold exactly; a value is the same everywhere if the
   maxima of it and of its negative add up to 0. */
static dem_result demi_slabs_same(dem_slabs *s, dem_world *w, int ok) {
    uint64_t digest = demi_scene_digest(w) ^ (dem_world_hash_get(w) << 1);
    double v[9], slabs = s->local;
    dem_result result;
    int k, differ = 0;
    digest = demi_hash(digest, &w->stage.list_valid, sizeof w->stage.list_valid);
    if (w->bodies.count)
        digest = demi_hash(digest, w->bodies.slot, (size_t)w->bodies.count*sizeof(uint32_t));
    v[0] = (double)(digest >> 32);
    v[2] = (double)(digest & 0xffffffffu);
    v[4] = s->count;
    v[6] = s->axis;
    for (k = 1; k < 8; k += 2) v[k] = -v[k - 1];
    v[8] = !ok;
    result = demi_slabs_reduce(s, v, 9, 0);
    if (result == DEM_OK) result = demi_slabs_reduce(s, &slabs, 1, 1);
    if (result != DEM_OK) return demi_fail(w, result, "%s", s->head.error);
    if (v[8] > 0) return demi_no_memory(w, "dem_slabs_create");
    for (k = 0; k < 8; k += 2) differ |= v[k] + v[k + 1] > 0;
    if (!differ && (int)slabs == s->count) return DEM_OK;
    return demi_refuse(w, "dem_slabs_create", "processes %s and together hold %d slabs of %d; "
                       "build the same world from the same numbers in every process, search or "
                       "step it in all or none, and assign every slab once",
                       differ ? "built different scenes" : "do not match", (int)slabs, s->count);
}

/* Fills the head from a world, allocates the arrays of `s` and sets the functions of the team.
   Returns 0 if memory ran out. */
static int demi_slabs_head(dem_slabs *s, const dem_world *w) {
    static const demi_team team = {0, 0, 0, demi_slabs_all, demi_slabs_agree, demi_slab_rest,
                                   demi_slabs_rebuild, demi_slabs_lend, demi_slabs_give,
                                   demi_slabs_grades, demi_slabs_feed, demi_slabs_sum};
    dem_world *h = &s->head;
    const size_t n = (size_t)s->count;
    h->asked = w->asked;
    demi_names_own(h, &w->asked);
    demi_bodies_begin(h);
    h->domains = &s->total;
    h->material_count = w->material_count;
    h->wall_count = w->wall_count;
    memcpy(h->materials, w->materials, sizeof h->materials);
    demi_rows_copy(demi_number_rows, h, w, DEMI_TO_HEAD);
    h->clock.last_rebuild = w->clock.steps;
    h->stage.forces_valid = w->stage.forces_valid && !w->stage.pairs_changed;
    h->pairs = (demi_pair *)demi_hold(h, DEMI_RUN, (size_t)DEMI_MATERIALS*DEMI_MATERIALS,
                                      sizeof(demi_pair));
    s->values = (double *)demi_hold(h, DEMI_RUN, n*DEMI_SLAB_BINS + 2*DEMI_MATERIALS + 8,
                                    sizeof(double));
    s->borders = (double *)demi_hold(h, DEMI_RUN, n + 1, sizeof(double));
    s->slabs = (demi_slab *)demi_hold(h, DEMI_RUN, (size_t)s->local, sizeof(demi_slab));
    h->team = &s->team;
    s->team = team;
    s->team.head = h;
    s->team.members = (dem_world **)demi_hold(h, DEMI_RUN, (size_t)s->local, sizeof(dem_world *));
    if (!h->pairs || !s->values || !s->borders || !s->slabs || !s->team.members) return 0;
    memcpy(h->pairs, w->pairs, (size_t)DEMI_MATERIALS*DEMI_MATERIALS*sizeof(demi_pair));
    h->feed_count = w->feed_count;              /* slabs refer to the feeds of the head */
    return DEMI_COPY(h, h->feeds, w->feeds, w->feed_count) && demi_events_copy(h, w);
}
/* Sets the first borders: about the same number of grains in every slab. */
static void demi_slabs_first_borders(dem_slabs *s, const dem_world *w) {
    const int n = DEMI_SLAB_BINS*s->count;
    double ends[2] = {-1e300, -1e300}, lo[3], hi[3];
    int k;
    demi_domain_limits(w, lo, hi);
    s->borders[0] = s->ring ? lo[s->axis] : -1e300;
    s->borders[s->count] = s->ring ? hi[s->axis] : 1e300;
    demi_slabs_extent(s, w, ends);
    if (s->ring) { ends[0] = hi[s->axis]; ends[1] = -lo[s->axis]; }
    if (!(ends[0] > -ends[1])) { ends[0] = w->bodies.count ? ends[0] + 1e-3 : 1; ends[1] = 0; }
    for (k = 0; k < n; k++) s->values[k] = 0;
    demi_slabs_bin(s, w, 1, s->values, n, -ends[1], ends[0]);
    demi_slabs_lay(s, s->values, n, -ends[1], ends[0]);
}

DEM_API void dem_slabs_destroy(dem_slabs *s) {
    dem_allocator allocator;
    int k;
    if (!s || demi_null(&s->head, __func__, s, "slabs")) return;
    demi_calls(&s->head, __func__, 1);          /* the allocator sees incomplete slabs */
    for (k = 0; k < s->local && s->slabs; k++) dem_world_destroy(s->slabs[k].world);
    allocator = s->head.desc.allocator;
    demi_free_chain(&s->head, DEMI_RUN);
    demi_raw_free(0, &allocator, s, sizeof *s);
}
/* dem_slabs_create without the check for null. Returns null after an error. */
static dem_slabs *demi_slabs_make(dem_world *w, const dem_slabs_desc *desc) {
    const size_t slots = (size_t)w->bodies.slot_count + 1;
    dem_slabs *s;
    uint8_t *marks;
    int k, ok;
    if (demi_unbuilt(w, "dem_slabs_create") != DEM_OK || demi_slabs_check(w, desc) != DEM_OK)
        return 0;
    /* files the contact histories; the world keeps its list */
    if (!demi_flush_make(w) || (w->stage.list_valid && !demi_carry_collect(w))) {
        demi_no_memory(w, "dem_slabs_create");
        return 0;
    }
    s = (dem_slabs *)demi_raw_alloc(w, &w->desc.allocator, sizeof *s);
    if (!s) { demi_no_memory(w, "dem_slabs_create"); return 0; }
    memset(s, 0, sizeof *s);
    s->head.desc = w->desc;
    s->desc = *desc;
    s->axis = desc->axis;
    s->count = desc->count;
    s->first = desc->first;
    s->local = desc->local ? desc->local : desc->count;
    s->ring = s->count > 1 && w->desc.boundary[s->axis] == DEM_BOUNDARY_PERIODIC;
    s->period = (double)demi_periods_of(w).period[s->axis];
    marks = (uint8_t *)demi_alloc(w, slots, 1);
    ok = marks && demi_slabs_head(s, w);
    s->slots = s->told = s->dealt = w->bodies.slot_count;
    ok = ok && DEMI_GROW(&s->head, s->known, slots);
    for (k = 0; k < w->bodies.slot_count && ok; k++)
        s->known[k] = w->bodies.slot_index[k] < 0 ? 0 : w->bodies.slot_generation[k];
    if (ok) demi_slabs_first_borders(s, w);
    for (k = 0; k < s->local && ok; k++) {
        demi_slab *b = &s->slabs[k];
        b->index = s->first + k;
        b->world = demi_slab_world(s, w, b->index, k ? s->slabs[0].world : 0,
                                   &s->head.desc.allocator, &ok);
        ok = ok && demi_slab_fill(s, b, w, marks);
        s->team.members[k] = b->world;
        if (b->world) { b->world->team = &s->team; b->world->member = s->team.count++; }
    }
    if (ok) s->head.walls = s->slabs[0].world->walls;
    demi_free(w, marks);
    if (demi_slabs_same(s, w, ok) == DEM_OK) return s;
    dem_slabs_destroy(s);
    return 0;
}
DEM_API dem_slabs *dem_slabs_create(dem_world *w, const dem_slabs_desc *desc) {
    demi_calling was;
    dem_slabs *s;
    if (demi_null(w, __func__, desc, "desc")) return 0;
    was = demi_calls(w, __func__, 1);
    s = demi_slabs_make(w, desc);
    demi_called(w, was);
    return s;
}

/* --- collect --- */

/* The begin of a slab's report. The loads of walls, the sums of fields and the states of outlets
   follow, and then a message with the grains and contact histories (demi_pack). */
typedef struct demi_slab_sums {
    int32_t index, walls;          /* of the slab; number of walls */
    uint64_t size, left;           /* bytes of the report; grains that outflow and outlets took */
    int64_t contacts;              /* of bodies, in the last step */
    demi_booked booked;
} demi_slab_sums;

/* Appends the report of one slab to s->mine. Returns 0 if memory ran out. */
static int demi_slab_report(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world, *h = &s->head;
    demi_message *out = &s->mine;
    const size_t start = out->size;
    demi_slab_sums sums;
    int i, ok;
    memset(&sums, 0, sizeof sums);
    sums.index = b->index;
    sums.walls = w->wall_count;
    sums.left = w->bodies.balance.left;
    sums.booked = w->booked;
    for (i = 0; i < w->domain_count; i++) sums.contacts += w->domains[i].contacts;
    if (w->stage.list_valid) demi_met_look(w, sums.booked.met);
    ok = demi_message_put(h, out, &sums, sizeof sums);
    for (i = 0; i < w->wall_count && ok; i++)
        ok = demi_message_put(h, out, &w->walls[i].loads, sizeof(dem_wall_loads));
    for (i = 0; i < w->field_count && ok; i++) {
        const demi_field *f = &w->fields[i];
        ok = demi_message_put(h, out, f->sums, demi_field_reals(f)*sizeof(double));
    }
    for (i = 0; i < w->outlet_count && ok; i++)
        ok = demi_message_put(h, out, &demi_outlet_at(w, i)->state, sizeof(dem_outlet_state));
    ok = ok && (!w->stage.list_valid || demi_carry_collect(w)) &&
         demi_pack(h, w, w->bodies.ghost, DEMI_ALL, 1, s->axis, 0, out);
    if (!ok) return 0;
    sums.size = out->size - start;
    memcpy(out->bytes + start, &sums, sizeof sums);
    return 1;
}
/* Collects the reports of all slabs in s->all, in every process. In each round a process passes up
   the ring what it received from below in the round before. */
static dem_result demi_slabs_gather(dem_slabs *s) {
    demi_slab *low = &s->slabs[0], *top = &s->slabs[s->local - 1];
    double processes = 1;
    dem_result result = demi_slabs_reduce(s, &processes, 1, 1);
    int round, k;
    s->mine.size = s->all.size = 0;
    for (k = 0; k < s->local; k++)
        if (s->slabs[k].result == DEM_OK && !demi_slab_report(s, &s->slabs[k]))
            s->slabs[k].result = demi_no_memory(s->slabs[k].world, "dem_slabs_collect");
    for (round = 0; round < (int)processes && result == DEM_OK; round++) {
        const demi_message *come = round ? &low->in[0] : &s->mine;
        if (round) result = demi_slabs_exchange(s, DEMI_UP, 0);
        if (result != DEM_OK) break;
        top->out[1].size = 0;
        if (!demi_message_put(&s->head, &s->all, come->bytes, come->size) ||
            !demi_message_put(top->world, &top->out[1], come->bytes, come->size))
            top->result = demi_no_memory(top->world, "dem_slabs_collect");
        result = demi_slabs_agree(&s->head, 0, 0);
    }
    return result;
}
/* Finds the report of one slab: fills *sums and returns what follows it; null if it is missing. */
static const char *demi_slabs_find(const dem_slabs *s, int index, demi_slab_sums *sums) {
    const char *from = s->all.bytes, *end = from + s->all.size;
    for (; from < end; from += sums->size) {
        memcpy(sums, from, sizeof *sums);
        if (sums->index == index) return from + sizeof *sums;
    }
    return 0;
}
/* Adds the sums of a report to those of the world, which were set to 0 before. Returns the begin of
   the report's message of grains. */
static const char *demi_slabs_add(dem_world *w, const demi_slab_sums *sums, const char *from) {
    int i;
    demi_rows_add(demi_booked_rows, &w->booked, &sums->booked);
    demi_crushed_add(&w->booked.crushed, &sums->booked.crushed);
    w->bodies.balance.left += sums->left;
    w->domains[0].contacts += (int)sums->contacts;
    for (i = 0; i < sums->walls; i++) {
        dem_wall_loads part;
        demi_unpack(&from, &part, sizeof part);
        demi_rows_add(demi_loads_rows, &w->walls[i].loads, &part);
        w->walls[i].loads.time = part.time;
    }
    for (i = 0; i < w->field_count; i++) {
        demi_field *f = &w->fields[i];
        size_t n;
        for (n = 0; n < demi_field_reals(f); n++) {
            double part;
            demi_unpack(&from, &part, sizeof part);
            f->sums[n] += part;
        }
    }
    for (i = 0; i < w->outlet_count; i++) {
        dem_outlet_state part;
        demi_unpack(&from, &part, sizeof part);
        demi_rows_add(demi_outlet_state_rows, &demi_outlet_at(w, i)->state, &part);
    }
    return from;
}
/* Returns the begin of that message without adding anything. */
static const char *demi_slabs_skip(const dem_world *w, const demi_slab_sums *sums,
                                   const char *from) {
    int i;
    from += (size_t)sums->walls*sizeof(dem_wall_loads);
    for (i = 0; i < w->field_count; i++) from += demi_field_reals(&w->fields[i])*sizeof(double);
    return from + (size_t)w->outlet_count*sizeof(dem_outlet_state);
}
/* Copies to the world what is the same in all slabs (time, time step, poses of walls, feeds), and
   sets its sums to 0. */
static void demi_slabs_common(const dem_slabs *s, dem_world *w) {
    const dem_world *h = &s->head, *from = s->slabs[0].world;
    int i;
    demi_rows_copy(demi_number_rows, w, h, DEMI_HEADS);
    demi_rows_copy(demi_number_rows, w, from, DEMI_FIRSTS);
    demi_rows_copy(demi_booked_rows, &w->booked, &h->booked, DEMI_HEADS);
    if (s->count == 1) w->margin.skin_auto = from->margin.skin_auto;
    demi_slab_sums_clear(w, DEMI_SUM | DEMI_LARGEST);
    memset(&w->booked.crushed, 0, sizeof w->booked.crushed);
    for (i = 0; i < w->wall_count; i++) {
        if (w->walls[i].idle != from->walls[i].idle) demi_surfaces_outdated(w);
        w->walls[i].idle = from->walls[i].idle;
        w->walls[i].pose = from->walls[i].pose;
        w->walls[i].servo = from->walls[i].servo;
        w->walls[i].mid = from->walls[i].mid;
    }
    for (i = 0; i < w->feed_count; i++) {
        const dem_feed_desc desc = w->feeds[i].desc;           /* its pointers are the world's */
        w->feeds[i] = h->feeds[i];
        w->feeds[i].desc = desc;
    }
    for (i = 0; i < w->field_count; i++) {
        demi_field *f = &w->fields[i];
        memset(f->sums, 0, demi_field_reals(f)*sizeof(double));
        f->samples = from->fields[i].samples;
        f->next = from->fields[i].next;
    }
}
/* Writes the grains and contact histories of one slab to the world. Grains that feeds have inserted
   are new in the world. seen: by slot, 1 for grains in any slab. */
static void demi_slabs_write(dem_world *w, int32_t *add, uint8_t *seen, const char *from) {
    demi_message_head head;
    int i;
    demi_unpack(&from, &head, sizeof head);
    for (i = 0; i < head.grains; i++) {
        const uint32_t slot = demi_grain_slot(from);
        if (w->bodies.slot_index[slot] < 0) {
            w->bodies.slot_index[slot] = w->bodies.count++;
            w->bodies.balance.present++;
        }
        demi_grain_unpack(w, w->bodies.slot_index[slot], &from);
        seen[slot] = 1;
    }
    demi_lll_outdated(w);
    demi_filed_unpack(w, add, &head, from);
}
/* Adds the slots of grains inserted since the last collection to the world, without bodies yet. */
static void demi_slabs_slots(const dem_slabs *s, dem_world *w) {
    for (; w->bodies.slot_count < s->slots; w->bodies.slot_count++) {
        w->bodies.slot_generation[w->bodies.slot_count] = 1;
        w->bodies.slot_index[w->bodies.slot_count] = -1;
    }
}
/* Frees the slots from `first` on whose grains have left the scene again. */
static void demi_slabs_slots_free(dem_world *w, const uint8_t *seen, int first) {
    int slot;
    for (slot = w->bodies.slot_count - 1; slot >= first; slot--) {
        if (seen[slot]) continue;
        w->bodies.slot_generation[slot]++;
        w->bodies.slot_index[slot] = -2 - w->bodies.slot_free;
        w->bodies.slot_free = slot;
    }
}
/* Checks that the world can take the reports: it must be the scene of the slabs, without walls or
   grains added or removed since. Then drops its list, allocates room for the reports, and clears
   the contact histories. */
static dem_result demi_slabs_room(dem_slabs *s, dem_world *w, int32_t **add, uint8_t **seen) {
    const char *call = "dem_slabs_collect";
    dem_world *h = &s->head;
    demi_slab_sums sums;
    demi_message_head come = {0, 0, 0, 0};
    int k, i;
    if (w->bodies.orienting != s->slabs[0].world->bodies.orienting)
        return demi_refuse(h, call, "bodies have orientations only in %s; collect into the world "
                           "from which the slabs were created, unchanged, or one built like it",
                           w->bodies.orienting ? "the world" : "the slabs");
    if (w->bodies.slot_count < s->dealt || w->wall_count != h->wall_count ||
        w->material_count != h->material_count || w->feed_count != h->feed_count ||
        w->field_count != s->slabs[0].world->field_count ||
        w->outlet_count != s->slabs[0].world->outlet_count ||
        demi_body_size(w) != demi_body_size(s->slabs[0].world))
        return demi_refuse(h, call, "the world has %d slots, %d walls, %d materials, %d feeds, the "
                           "slabs %d, %d, %d, %d; collect into the world from which they were "
                           "created, unchanged, or one built like it", w->bodies.slot_count,
                           w->wall_count, w->material_count, w->feed_count, s->dealt, h->wall_count,
                           h->material_count, h->feed_count);
    for (i = 0; i < w->wall_count; i++) {       /* another wall may have this index now */
        const demi_wall *here = &w->walls[i], *there = &s->slabs[0].world->walls[i];
        const int none = here->kind == DEMI_WALL_NONE, gone = there->kind == DEMI_WALL_NONE;
        if (none == gone && (none || here->id == there->id)) continue;
        return demi_refuse(h, call, "wall %d was %s the world after the slabs were created; "
                           "collect before adding or removing walls, or create the slabs again "
                           "afterwards", (int)here->id, none ? "removed from" : "added to");
    }
    for (i = 0; i < w->bodies.count; i++) {
        const uint32_t slot = w->bodies.slot[i];
        if ((int)slot >= s->told || w->bodies.slot_generation[slot] != s->known[slot])
            return demi_refuse(h, call, "body %u was added to the world after the slabs were "
                               "created; collect before adding grains, or create the slabs again "
                               "afterwards", (unsigned)slot + 1);
    }
    for (k = 0; k < s->count; k++) {
        const char *from = demi_slabs_find(s, k, &sums);
        demi_message_head head;
        if (!from)
            return demi_fail(h, DEM_ERROR_STOPPED, "%s: slab %d did not report; check that every "
                             "process makes this call and that the ring of processes is closed",
                             call, k);
        from = demi_slabs_skip(w, &sums, from);
        demi_unpack(&from, &head, sizeof head);
        come.pairs += head.pairs;
        come.contacts += head.contacts;
        if (head.pairs) come.stride = head.stride;
        for (i = 0; i < head.grains; i++) {
            const uint32_t slot = demi_grain_slot(from);
            from += demi_body_size(w);
            if ((int)slot < w->bodies.slot_count && w->bodies.slot_index[slot] < 0)
                return demi_refuse(h, call, "body %u is in slab %d, but no longer in the world; "
                                   "collect before removing grains, or create the slabs again "
                                   "afterwards", (unsigned)slot + 1, k);
        }
    }
    if (!demi_list_drop(w)) return demi_no_memory(h, call);
    i = w->bodies.slot_count;
    if (!DEMI_GROW(h, *seen, (size_t)s->slots + 1) ||
        !demi_bodies_reserve(w, (size_t)w->bodies.count + (size_t)DEMI_MAX(s->slots - i, 0)))
        return demi_no_memory(h, call);
    demi_slabs_slots(s, w);
    if (!demi_filed_reserve(w, add, &come) || (h->events.n.on && !demi_events_copy(w, h))) {
        w->bodies.slot_count = i;
        return demi_no_memory(h, call);
    }
    for (k = 0; k < DEMI_DOMAINS; k++)          /* those of the slabs take over */
        w->domains[k].persistent = w->domains[k].contacts = 0;
    demi_filed_forget(w);
    memset(w->filed.start, 0, ((size_t)w->filed.rows + 2)*sizeof(int32_t));
    memset(*seen, 0, (size_t)s->slots + 1);
    return DEM_OK;
}
DEM_API dem_result dem_slabs_collect(dem_slabs *s, dem_world *w) {
    if (!s || demi_null(&s->head, __func__, w, "world") ||
        demi_null(w, __func__, w, "world")) return DEM_ERROR_ARGUMENT;
    int32_t *add = 0;
    uint8_t *seen = 0;
    dem_result result = demi_slabs_usable(s, __func__);
    const int slots = w->bodies.slot_count;
    demi_calling was[2];
    demi_slab_sums sums;
    int k, i;
    was[0] = demi_calls(&s->head, __func__, 1);
    was[1] = demi_calls(w, __func__, 1);
    if (result == DEM_OK) result = demi_slabs_gather(s);
    if (result == DEM_OK) result = demi_slabs_room(s, w, &add, &seen);
    if (result == DEM_OK) {
        demi_slabs_common(s, w);
        for (k = 0; k < s->count; k++) {
            const char *from = demi_slabs_find(s, k, &sums);
            from = demi_slabs_add(w, &sums, from);
            demi_slabs_write(w, add, seen, from);
        }
        demi_slabs_slots_free(w, seen, slots);
        s->told = s->slots;
        /* not in any slab: it left through an outflow boundary or an outlet */
        for (i = w->bodies.count - 1; i >= 0; i--)
            if (!seen[w->bodies.slot[i]]) demi_body_take_out(w, i);
        /* counts of the slabs replace those of the world */
        w->bodies.balance.inserted = s->head.bodies.balance.inserted;
        w->bodies.balance.removed = s->head.bodies.balance.removed;
        if (w->events.n.on && !s->head.events.n.on) demi_events_start(w);
        demi_effects(w);                        /* the world itself may never have been stepped */
    }
    demi_called(w, was[1]);
    demi_called(&s->head, was[0]);
    demi_free(w, add);
    demi_free(&s->head, seen);
    return result;
}
DEM_API void dem_slabs_loads_reset(dem_slabs *s) {
    if (!s || demi_null(&s->head, __func__, s, "slabs")) return;
    int k, i;
    for (k = 0; k < s->local; k++) {
        dem_world *w = s->slabs[k].world;
        w->booked.overlap_max = 0;
        memset(&w->booked.crushed, 0, sizeof w->booked.crushed);
        for (i = 0; i < w->wall_count; i++) demi_loads_reset(&w->walls[i].loads);
    }
}

DEM_API const char *dem_slabs_error_get(const dem_slabs *s) {
    return s ? s->head.error : "dem_slabs_create: returned null; dem_world_error_get(world) says "
    "why";
}
DEM_API dem_result dem_slab_get(const dem_slabs *s, int index, dem_slab *out) {
    if (!s || demi_null_look(&s->head, __func__, out, "slab")) return DEM_ERROR_ARGUMENT;
    const demi_slab *b;
    if (index < s->first || index >= s->first + s->local)
        return demi_refuse(&s->head, __func__, "slab %d is not here, this process holds "
                           "slabs %d to %d of %d; make this call in the process that holds it",
                           index, s->first, s->first + s->local - 1, s->count);
    b = &s->slabs[index - s->first];
    out->grains = b->world->bodies.count - b->ghost_count;
    out->ghosts = b->ghost_count;
    out->lo = s->borders[index];
    out->hi = s->borders[index + 1];
    out->work = b->work;
    out->seconds = b->seconds;
    out->bytes = b->bytes;
    return DEM_OK;
}
DEM_API dem_slabs_counters dem_slabs_counters_get(const dem_slabs *s) {
    dem_slabs_counters c;
    int k;
    memset(&c, 0, sizeof c);
    if (!s) return c;
    c.time = s->head.clock.time;
    c.steps = demi_steps_done(&s->head);
    c.rebuilds = s->head.clock.rebuilds;
    c.border_moves = s->border_moves;
    for (k = 0; k < s->local; k++) c.migrated += s->slabs[k].migrated;
    c.skin = (dem_real)s->head.margin.skin;
    c.dt = s->head.clock.dt;
    return c;
}
