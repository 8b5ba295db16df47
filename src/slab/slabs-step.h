/* ---------------------------------------------------------------------------------------------
   >>slabs-step
   One step of all slabs: phases, what goes to neighbours, what is agreed on, new lists, borders.
   --------------------------------------------------------------------------------------------- */

/* One slab's share of a phase, timed. */
static void demi_slab_task(dem_world *w, int k) {
    dem_slabs *s = (dem_slabs *)(void *)w;      /* the head comes first */
    const double begun = demi_clock();
    s->phase(s, &s->slabs[k]);
    s->slabs[k].seconds += demi_clock() - begun;
}
static void demi_slabs_phase(dem_slabs *s, void (*phase)(dem_slabs *, demi_slab *)) {
    s->phase = phase;
    demi_parallel(&s->head, s->head.desc.threads, s->local, demi_slab_task);
}

/* Is there a slab above (side 1) or below (side 0)? */
static int demi_slab_has(const dem_slabs *s, const demi_slab *b, int side) {
    return s->ring || (side ? b->index + 1 < s->count : b->index > 0);
}
/* What the neighbour on one side sent here. */
static const demi_message *demi_slab_inbox(const dem_slabs *s, const demi_slab *b, int side) {
    int k = b->index - s->first + (side ? 1 : -1);
    if (s->local == s->count) k = (k + s->count)%s->count;
    return k >= 0 && k < s->local ? &s->slabs[k].out[!side] : &b->in[side];
}

/* From here on processes may differ: nothing but collecting from elsewhere makes sense. */
static dem_result demi_slabs_transport_failed(dem_slabs *s, const char *what, int answer) {
    s->broken = 1;
    return demi_fail(&s->head, DEM_ERROR_STOPPED, "dem_slabs_step: %s of the transport returned "
                     "%d, must be 0; the slabs cannot continue: repair the connection and create "
                     "them again from the last collected world or checkpoint", what, answer);
}
/* Maxima over processes, or sums, which are of whole numbers. */
static dem_result demi_slabs_reduce(dem_slabs *s, double *values, int count, int sum) {
    int answer;
    if (s->local == s->count) return DEM_OK;
    answer = s->desc.transport.reduce_fn(values, count, sum, s->desc.transport.user);
    return answer ? demi_slabs_transport_failed(s, "reduce_fn", answer) : DEM_OK;
}

/* Looks at the results of the last phases. When one is bad, all processes return it; the sentence
   is that of the lowest slab concerned. flags (count): replaced by their maxima over processes. */
static dem_result demi_slabs_agree(dem_slabs *s, double *flags, int count) {
    double v[8] = {0, 0, 0, 0, 0, 0, 0, 0};
    dem_result result;
    int k, index;
    for (k = 0; k < s->local; k++) {
        demi_slab *b = &s->slabs[k];
        if (b->result == DEM_OK) continue;
        v[0] = DEMI_MAX(v[0], (s->count - b->index)*16.0 + (double)b->result);
    }
    for (k = 0; k < count; k++) v[1 + k] = flags[k];
    result = demi_slabs_reduce(s, v, 1 + count, 0);
    if (result != DEM_OK) return result;
    for (k = 0; k < count; k++) flags[k] = v[1 + k];
    for (k = 0; k < s->local; k++) s->slabs[k].result = DEM_OK;
    if (!(v[0] > 0)) return DEM_OK;
    index = s->count - (int)v[0]/16;
    result = (dem_result)((int)v[0]%16);
    if (index >= s->first && index < s->first + s->local)
        return demi_fail(&s->head, result, "dem_slabs_step: slab %d: %.440s", index,
                         s->slabs[index - s->first].world->error);
    return demi_fail(&s->head, result, "dem_slabs_step: slab %d stopped: %s; the process that "
                     "holds it has the message", index, dem_result_name_get(result));
}

/* Outboxes that lead to other processes, up, down or both ways. Sizes are told first unless both
   ends know them. */
static dem_result demi_slabs_exchange(dem_slabs *s, int ways, int sized) {
    demi_slab *low = &s->slabs[0], *top = &s->slabs[s->local - 1];
    const dem_transport *t = &s->desc.transport;
    uint64_t send[2] = {0, 0}, get[2] = {0, 0};
    dem_result result;
    int k, answer;
    for (k = 0; k < s->local; k++) {
        demi_slab *b = &s->slabs[k];
        if (ways & DEMI_DOWN && demi_slab_has(s, b, 0)) b->bytes += b->out[0].size;
        if (ways & DEMI_UP && demi_slab_has(s, b, 1)) b->bytes += b->out[1].size;
    }
    if (s->local == s->count) return DEM_OK;
    if (ways & DEMI_DOWN) send[0] = low->out[0].size;
    if (ways & DEMI_UP) send[1] = top->out[1].size;
    if (sized) {
        if (ways & DEMI_DOWN) get[1] = top->in[1].size;
        if (ways & DEMI_UP) get[0] = low->in[0].size;
    } else {
        answer = t->exchange_fn(&send[0], 8, &get[0], 8, &send[1], 8, &get[1], 8, t->user);
        if (answer) return demi_slabs_transport_failed(s, "exchange_fn", answer);
        if (!DEMI_GROW(low->world, low->in[0].bytes, (size_t)get[0]) ||
            !DEMI_GROW(top->world, top->in[1].bytes, (size_t)get[1]))
            low->result = demi_no_memory(low->world, "dem_slabs_step");
        result = demi_slabs_agree(s, 0, 0);
        if (result != DEM_OK) return result;
        low->in[0].size = (size_t)get[0];
        top->in[1].size = (size_t)get[1];
    }
    answer = t->exchange_fn(low->out[0].bytes, (size_t)send[0],
                            low->in[0].bytes, (size_t)get[0],
                            top->out[1].bytes, (size_t)send[1],
                            top->in[1].bytes, (size_t)get[1], t->user);
    return answer ? demi_slabs_transport_failed(s, "exchange_fn", answer) : DEM_OK;
}

/* --- borders --- */

/* Borders that share the weight in `bins` (n of them over lo..hi) out evenly. */
static void demi_slabs_lay(dem_slabs *s, const double *bins, int n, double lo, double hi) {
    double total = 0, sum = 0;
    int i, j = 1;
    for (i = 0; i < n; i++) total += bins[i];
    for (i = 0; i < n; i++) {
        for (; j < s->count && bins[i] > 0 && sum + bins[i] >= total*j/s->count; j++)
            s->borders[j] = lo + (hi - lo)*(i + (total*j/s->count - sum)/bins[i])/n;
        sum += bins[i];
    }
    for (; j < s->count; j++) s->borders[j] = hi;
}
/* No slab thinner than the cut. Outermost slabs of an open axis have no end. */
static void demi_slabs_space(dem_slabs *s) {
    double *b = s->borders;
    int j;
    for (j = s->ring ? 1 : 2; j < s->count; j++) b[j] = DEMI_MAX(b[j], b[j - 1] + s->cut);
    for (j = s->count - 1; s->ring && j > 0; j--) b[j] = DEMI_MIN(b[j], b[j + 1] - s->cut);
}
/* Adds a slab's own grains to bins. */
static void demi_slabs_bin(const dem_slabs *s, const dem_world *w, double weight, double *bins,
                           int n, double lo, double hi) {
    int i;
    for (i = 0; i < w->bodies.count; i++) {
        const double t = ((double)w->bodies.pos[4*i + s->axis] - lo)/(hi - lo)*n;
        if (!demi_is_ghost(w, i)) bins[t > 0 ? t < n ? (int)t : n - 1 : 0] += weight;
    }
}
/* The highest place of its own grains, and minus the lowest: one reduction finds both. */
static void demi_slabs_extent(const dem_slabs *s, const dem_world *w, double *ends) {
    int i;
    for (i = 0; i < w->bodies.count; i++) {
        const double x = (double)w->bodies.pos[4*i + s->axis];
        if (demi_is_ghost(w, i)) continue;
        ends[0] = DEMI_MAX(ends[0], x);
        ends[1] = DEMI_MAX(ends[1], -x);
    }
}
/* Moves the borders when counted work is shared too unevenly: each grain weighs what a grain of its
   slab costs on average, in whole numbers, so that sums are the same in any order. */
static dem_result demi_slabs_balance(dem_slabs *s) {
    const int n = DEMI_SLAB_BINS*s->count;
    const int every = s->desc.balance_interval > 0 ? s->desc.balance_interval : 8;
    const double limit = s->desc.balance > 0 ? (double)s->desc.balance : 1.1;
    double *v = s->values, ends[2] = {-1e300, -1e300}, most = 0, total = 0;
    dem_result result;
    int k;
    if (s->desc.balance < 0 || s->head.clock.rebuilds == 0 ||
        s->head.clock.rebuilds%(uint64_t)every)
        return DEM_OK;
    for (k = 0; k < s->count; k++) v[k] = 0;
    for (k = 0; k < s->local; k++) v[s->first + k] = s->slabs[k].work;
    result = demi_slabs_reduce(s, v, s->count, 0);
    for (k = 0; k < s->count; k++) { total += v[k]; most = DEMI_MAX(most, v[k]); }
    if (result != DEM_OK || !(most*s->count > limit*total)) return result;
    for (k = 0; k < s->local; k++) demi_slabs_extent(s, s->slabs[k].world, ends);
    result = demi_slabs_reduce(s, ends, 2, 0);
    if (result != DEM_OK || !(ends[0] > -ends[1])) return result;
    if (s->ring) { ends[0] = s->borders[s->count]; ends[1] = -s->borders[0]; }
    for (k = 0; k < n; k++) v[k] = 0;
    for (k = 0; k < s->local; k++) {
        const dem_world *w = s->slabs[k].world;
        const int home = w->bodies.count - s->slabs[k].ghost_count;
        const double each = home > 0 ? floor(16*s->slabs[k].work/home + 0.5) : 1;
        demi_slabs_bin(s, w, DEMI_MAX(each, 1), v, n, -ends[1], ends[0]);
    }
    result = demi_slabs_reduce(s, v, n, 1);
    if (result != DEM_OK) return result;
    demi_slabs_lay(s, v, n, -ends[1], ends[0]);
    s->border_moves++;
    return DEM_OK;
}

/* The skin of a rebuild, by the model that serves a single world, from totals over all slabs; and
   with it the thinnest slab there may be. */
static dem_result demi_slabs_skin(dem_slabs *s) {
    double sums[3] = {0, 0, 0}, radii[3] = {0, -1e300, 0};    /* largest, -smallest; near_span */
    dem_world *h = &s->head;
    dem_result result;
    int k, i, d;
    for (k = 0; k < s->local; k++) {
        const dem_world *w = s->slabs[k].world;
        radii[2] = DEMI_MAX(radii[2], w->margin.span);
        for (d = 0; d < w->domain_count; d++) {
            sums[0] += w->domains[d].own + w->domains[d].cross;
            sums[1] += w->domains[d].contacts;
        }
        for (i = 0; i < w->bodies.count; i++) {
            const double r = (double)w->bodies.pos[4*i + 3];
            if (demi_is_ghost(w, i)) continue;
            sums[2]++;
            radii[0] = DEMI_MAX(radii[0], r);
            radii[1] = DEMI_MAX(radii[1], -r);
        }
    }
    result = demi_slabs_reduce(s, sums, 3, 1);
    if (result == DEM_OK) result = demi_slabs_reduce(s, radii, 3, 0);
    if (result != DEM_OK) return result;
    h->domain_count = 1;
    s->total.own = (int)DEMI_MIN(sums[0], (double)INT_MAX);
    s->total.contacts = (int)DEMI_MIN(sums[1], (double)INT_MAX);
    h->bodies.count = (int)sums[2];
    h->effects.radius_max = (dem_real)radii[0];
    h->effects.radius_min = (dem_real)(h->bodies.count ? -radii[1] : 0);
    h->margin.span = radii[2];
    h->margin.reach = demi_reach_of(h, radii[0]);
    demi_skin_choose(h);
    if (s->ring && h->desc.skin >= 0 && h->desc.skin <= 0) {
        const double room = s->period/s->count/(1 + 2e-6) - 2*radii[0] - h->margin.reach;
        if (room > 0) h->margin.skin = h->margin.skin_auto = DEMI_MIN(h->margin.skin, room);
    }
    h->margin.skin = (double)(dem_real)h->margin.skin;        /* as the slabs get it */
    s->cut = (2*radii[0] + (double)demi_cover(h))*(1 + 1e-6);  /* rounding costs no ghost */
    if (s->ring && s->cut*s->count > s->period)
        return demi_fail(h, DEM_ERROR_ARGUMENT, "dem_slabs_step: %d slabs in a period of %g m are "
                         "%g m thick, must be at least %g m (two grains and the skin%s); use at "
                         "most %d slabs or a smaller skin", s->count, s->period,
                         s->period/s->count, s->cut, h->margin.reach > 0
                         ? " and the law's range" : "", (int)(s->period/s->cut));
    return DEM_OK;
}

/* --- a rebuild, phase by phase --- */

/* Memory is filed, ghosts are dropped. */
static void demi_slab_drop(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    int i;
    (void)s;
    if (!demi_list_drop(w)) { b->result = demi_no_memory(w, "dem_slabs_step"); return; }
    for (i = w->bodies.count - 1; i >= 0; i--) if (demi_is_ghost(w, i)) demi_grain_forget(w, i);
    b->ghost_count = b->lent_count = 0;
}
/* Where a grain belongs: -1 below, 0 here, 1 above; *shift: what its position changes by on the
   way. A grain that a whole period would put back on the same border stays. */
static int demi_slab_side(const dem_slabs *s, const demi_slab *b, dem_real x, dem_real *shift) {
    const dem_real period = (dem_real)s->period;
    *shift = 0;
    if ((double)x < s->borders[b->index]) {
        if (b->index == 0) *shift = period;
        return b->index == 0 && (double)(x + period) >= s->borders[s->count] ? 0 : -1;
    }
    if ((double)x >= s->borders[b->index + 1]) {
        if (b->index == s->count - 1) *shift = -period;
        return 1;
    }
    return 0;
}
static dem_real demi_slab_shift(const dem_slabs *s, const demi_slab *b, int side) {
    if (side && b->index == s->count - 1) return -(dem_real)s->period;
    return !side && b->index == 0 ? (dem_real)s->period : 0;
}
/* Those that crossed a border go into the outboxes; they stay here until there is room for them. */
static void demi_slab_leave(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    dem_real shift;
    int i, side, ok = 1, going[2] = {0, 0};
    for (i = 0; i < w->bodies.count; i++) {
        side = demi_slab_side(s, b, w->bodies.pos[4*i + s->axis], &shift);
        if (!side) continue;
        w->bodies.ghost[w->bodies.slot[i]] = side < 0 ? DEMI_GOES_DOWN : DEMI_GOES_UP;
        going[side > 0]++;
    }
    b->leavers = going[0] + going[1];
    for (side = 0; side < 2; side++) {
        b->out[side].size = 0;
        ok = ok && demi_pack(w, w, w->bodies.ghost, side ? DEMI_GOES_UP : DEMI_GOES_DOWN,
                             going[side] > 0, s->axis, demi_slab_shift(s, b, side), &b->out[side]);
    }
    for (i = 0; b->leavers && i < w->bodies.count; i++) w->bodies.ghost[w->bodies.slot[i]] = 0;
    if (!ok) b->result = demi_no_memory(w, "dem_slabs_step");
}
/* What a neighbour sent, in numbers, and where its grains begin; zeros where there is none. */
static demi_message_head demi_slab_head(const dem_slabs *s, const demi_slab *b, int side,
                                       const char **grains) {
    demi_message_head head = {0, 0, 0, 0};
    if (demi_slab_has(s, b, side)) {
        *grains = demi_slab_inbox(s, b, side)->bytes;
        demi_unpack(grains, &head, sizeof head);
    }
    return head;
}
/* Room for all that arrives from both sides, before anything leaves. */
static void demi_slab_room(dem_slabs *s, demi_slab *b) {
    const char *from = 0;
    const demi_message_head l = demi_slab_head(s, b, 0, &from);
    const demi_message_head u = demi_slab_head(s, b, 1, &from);
    dem_world *w = b->world;
    demi_message_head come = {l.grains + u.grains, l.pairs + u.pairs, l.contacts + u.contacts, 0};
    come.stride = l.pairs ? l.stride : u.pairs ? u.stride : w->filed.stride;
    if (!demi_bodies_reserve(w, (size_t)w->bodies.count + (size_t)come.grains) ||
        !demi_filed_reserve(w, &b->add, &come))
        b->result = demi_no_memory(w, "dem_slabs_step");
}
/* Leavers go, arrivals come in: nothing can fail any more. */
static void demi_slab_migrate(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    dem_real shift;
    int i, side;
    for (i = w->bodies.count - 1; i >= 0; i--)
        if (demi_slab_side(s, b, w->bodies.pos[4*i + s->axis], &shift)) demi_grain_forget(w, i);
    b->migrated += (uint64_t)b->leavers;
    for (side = 0; side < 2; side++) {
        const char *from = 0;
        const demi_message_head h = demi_slab_head(s, b, side, &from);
        for (i = 0; i < h.grains; i++) demi_grain_append(w, &from);
        demi_filed_unpack(w, b->add, &h, from);
    }
}
/* Grains near enough to the upper border to touch something beyond it. */
static void demi_slab_invite(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    int i, n = 0;
    b->out[1].size = 0;
    if (!demi_slab_has(s, b, 1)) return;
    if (!DEMI_GROW(w, b->lent, (size_t)w->bodies.count)) {
        b->result = demi_no_memory(w, "dem_slabs_step");
        return;
    }
    for (i = 0; i < w->bodies.count; i++) {
        const double x = (double)w->bodies.pos[4*i + s->axis], r = (double)w->bodies.pos[4*i + 3];
        if (!(x + s->cut - (double)s->head.effects.radius_max +
              r > s->borders[b->index + 1])) continue;
        w->bodies.ghost[w->bodies.slot[i]] = DEMI_GHOST_ABOVE;
        b->lent[n++] = (int32_t)w->bodies.slot[i];
    }
    if (!demi_pack(w, w, w->bodies.ghost, DEMI_GHOST_ABOVE, 0, s->axis,
                   demi_slab_shift(s, b, 1),
                   &b->out[1])) b->result = demi_no_memory(w, "dem_slabs_step");
    for (i = 0; i < n; i++) w->bodies.ghost[b->lent[i]] = 0;
    b->lent_count = n;
}
/* Reals sent up and down per ghost and step: the user's numbers, or their rates, come last. */
static size_t demi_slab_places(const dem_world *w) {
    const size_t state = w->bodies.orienting ? 19 : demi_spins(w) ? 15 : 6;
    return state + (w->bodies.booked ? 3 : 0);
}
static size_t demi_slab_pushes(const dem_world *w) { return demi_turns(w) ? 6 : 3; }
static size_t demi_slab_up(const dem_world *w) {
    return demi_slab_places(w) + (size_t)w->bodies.real_count;
}
static size_t demi_slab_down(const dem_world *w) {
    return demi_slab_pushes(w) + (size_t)w->bodies.real_count;
}

/* Bytes of what goes up and down in a step. */
static void demi_slab_sizes(dem_slabs *s, demi_slab *b) {
    const size_t up = demi_slab_up(b->world)*sizeof(dem_real);
    const size_t down = demi_slab_down(b->world)*sizeof(dem_real);
    (void)s;
    b->in[0].size = (size_t)b->ghost_count*up;
    b->in[1].size = (size_t)b->lent_count*down;
    b->out[0].size = (size_t)b->ghost_count*down;
}
/* Ghosts come in; then the list is made as in any world, and steps get their room. */
static void demi_slab_list(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    const char *from = 0;
    const demi_message_head h = demi_slab_head(s, b, 0, &from);
    int i, d, ok;
    ok = demi_bodies_reserve(w, (size_t)w->bodies.count + (size_t)h.grains) &&
         DEMI_GROW(w, b->ghost, (size_t)h.grains) &&
         DEMI_GROW(w, b->ghost_inv, 2*(size_t)h.grains);
    if (!ok) { b->result = demi_no_memory(w, "dem_slabs_step"); return; }
    for (i = 0; i < h.grains; i++) {
        const int at = demi_grain_append(w, &from);
        w->bodies.ghost[w->bodies.slot[at]] = DEMI_GHOST;
        b->ghost[i] = (int32_t)w->bodies.slot[at];
        b->ghost_inv[2*i] = w->bodies.inv_mass[at];
        b->ghost_inv[2*i + 1] = w->bodies.inv_inertia[at];
    }
    b->ghost_count = h.grains;
    if (s->count > 1) w->desc.skin = s->head.margin.skin > 0 ? (dem_real)s->head.margin.skin : -1;
    b->result = demi_rebuild(w, "dem_world_step");
    if (b->result != DEM_OK) return;
    demi_kernel_choose(w);
    for (i = 0; i < b->ghost_count; i++) b->ghost[i] = w->bodies.slot_index[b->ghost[i]];
    for (i = 0; i < b->lent_count; i++) b->lent[i] = w->bodies.slot_index[b->lent[i]];
    demi_slab_sizes(s, b);
    b->work = 4.0*w->bodies.count;
    for (d = 0; d < w->domain_count; d++)
        b->work += w->domains[d].own + w->domains[d].cross + w->domains[d].walls;
}
/* The outboxes rest until everybody has taken from them; only then are they given their room. */
static void demi_slab_settle(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    (void)s;
    b->out[1].size = (size_t)b->lent_count*demi_slab_up(w)*sizeof(dem_real);
    if (!DEMI_GROW(w, b->in[0].bytes, b->in[0].size) ||
        !DEMI_GROW(w, b->in[1].bytes, b->in[1].size) ||
        !DEMI_GROW(w, b->out[0].bytes, b->out[0].size) ||
        !DEMI_GROW(w, b->out[1].bytes, b->out[1].size))
        b->result = demi_no_memory(w, "dem_slabs_step");
}

/* Migration: round by round, since a grain moves on by one slab at a time. */
static dem_result demi_slabs_migrate(dem_slabs *s) {
    dem_result result;
    for (;;) {
        double leavers = 0;
        int k;
        demi_slabs_phase(s, demi_slab_leave);
        for (k = 0; k < s->local; k++) leavers = DEMI_MAX(leavers, s->slabs[k].leavers);
        result = demi_slabs_agree(s, &leavers, 1);
        if (result != DEM_OK || !(leavers > 0)) return result;
        result = demi_slabs_exchange(s, DEMI_UP | DEMI_DOWN, 0);
        if (result != DEM_OK) return result;
        demi_slabs_phase(s, demi_slab_room);
        result = demi_slabs_agree(s, 0, 0);
        if (result != DEM_OK) return result;
        demi_slabs_phase(s, demi_slab_migrate);
    }
}
/* DEM_ERROR_MEMORY leaves every grain in one slab and its memory beside it: the next call begins
   again. */
static dem_result demi_slabs_rebuild(dem_slabs *s) {
    dem_world *h = &s->head;
    const double skin_before = h->margin.skin_auto;
    dem_result result;
    h->stage.list_valid = 0;
    demi_slabs_phase(s, demi_slab_drop);
    result = demi_slabs_agree(s, 0, 0);
    if (s->count > 1) {
        if (result == DEM_OK) result = demi_slabs_skin(s);
        if (result == DEM_OK) result = demi_slabs_balance(s);
        if (result == DEM_OK) { demi_slabs_space(s); result = demi_slabs_migrate(s); }
        if (result == DEM_OK) {
            demi_slabs_phase(s, demi_slab_invite);
            result = demi_slabs_agree(s, 0, 0);
        }
        if (result == DEM_OK) result = demi_slabs_exchange(s, DEMI_UP, 0);
    }
    if (result == DEM_OK) {
        demi_slabs_phase(s, demi_slab_list);
        result = demi_slabs_agree(s, 0, 0);
    }
    if (result == DEM_OK) {
        demi_slabs_phase(s, demi_slab_settle);
        result = demi_slabs_agree(s, 0, 0);
    }
    if (result != DEM_OK) { h->margin.skin_auto = skin_before; return result; }
    if (s->count == 1) h->margin.skin = s->slabs[0].world->margin.skin;
    h->margin.gone = h->margin.walls_gone = 0;
    h->clock.last_rebuild = h->clock.steps;
    h->clock.rebuilds++;
    h->stage.list_valid = 1;
    return DEM_OK;
}

/* --- a step --- */

/* 1 move. Ghosts stand still, weightless: their owner moves them. */
static void demi_slab_move(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    int k;
    if (b->result != DEM_OK) return;            /* from the forces before: told with this step */
    for (k = 0; k < b->ghost_count && !s->head.stage.moved; k++) {
        const int i = b->ghost[k];
        w->bodies.inv_mass[i] = w->bodies.inv_inertia[i] = 0;
        demi_put(w->bodies.vel + 4*i, demi_v(0, 0, 0));      demi_put(w->bodies.half_vel + 4*i,
                                                                      demi_v(0, 0, 0));
        demi_put(w->bodies.spin + 4*i, demi_v(0, 0, 0));     demi_put(w->bodies.half_spin + 4*i,
                                                                      demi_v(0, 0, 0));
        demi_put(w->bodies.force + 4*i, demi_v(0, 0, 0));    demi_put(w->bodies.torque + 4*i,
                                                                      demi_v(0, 0, 0));
        if (w->bodies.backward) demi_put(w->bodies.last_pos + 4*i, demi_at(w->bodies.pos + 4*i));
    }
    if (!s->head.stage.moved) b->result = demi_step_move(w);
    if (b->result == DEM_OK) b->result = demi_outflow(w);
}
/* Outlets take what this slab owns; whoever lost one needs a new list. */
static void demi_slab_outlets(dem_slabs *s, demi_slab *b) {
    (void)s;
    b->result = demi_outlets_run(b->world);
}
/* Outlets of all slabs; *search: somebody lost a grain. */
static dem_result demi_slabs_outlets(dem_slabs *s, int *search) {
    dem_result result;
    double stale = 0;
    int k;
    demi_slabs_phase(s, demi_slab_outlets);
    for (k = 0; k < s->local; k++)
        stale = DEMI_MAX(stale, !s->slabs[k].world->stage.list_valid);
    result = demi_slabs_agree(s, &stale, 1);
    *search |= stale > 0;
    return result;
}
/* What the walls did, for those slabs whose walls do not move by themselves. */
static void demi_slabs_poses(dem_slabs *s) {
    const dem_world *from = s->slabs[0].world;
    int k, i;
    for (i = 0; i < from->wall_count; i++)
        for (k = 1; k < s->local && from->walls[i].motion.kind != DEM_MOTION_FIXED; k++) {
            s->slabs[k].world->walls[i].pose = from->walls[i].pose;
            s->slabs[k].world->walls[i].mid = from->walls[i].mid;
        }
}
/* State of the grains that are ghosts above: as much of it as the laws in force look at. */
static void demi_slab_send(dem_slabs *s, demi_slab *b) {
    const dem_world *w = b->world;
    const size_t three = 3*sizeof(dem_real), reals = demi_slab_places(w);
    const size_t own = (size_t)w->bodies.real_count;
    const dem_real shift = demi_slab_shift(s, b, 1);
    dem_real *out = (dem_real *)b->out[1].bytes;
    int k;
    for (k = 0; k < b->lent_count; k++, out += reals + own) {
        const int i = 4*b->lent[k];
        if (own) memcpy(out + reals, w->bodies.reals + own*(size_t)b->lent[k], own*sizeof *out);
        if (w->bodies.booked) memcpy(out + reals - 3, w->bodies.late + i, three);
        memcpy(out, w->bodies.pos + i, three);
        out[s->axis] += shift;
        memcpy(out + 3, w->bodies.vel + i, three);
        if (reals < 15) continue;
        memcpy(out + 6, w->bodies.spin + i, three);
        memcpy(out + 9, w->bodies.half_vel + i, three);
        memcpy(out + 12, w->bodies.half_spin + i, three);
        if (w->bodies.orienting) memcpy(out + 15, w->bodies.orient + i, 4*sizeof(dem_real));
    }
}
/* Ghosts are where their owners say. */
static void demi_slab_receive(const dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    const size_t three = 3*sizeof(dem_real), up = demi_slab_places(w);
    const size_t own = (size_t)w->bodies.real_count;
    const dem_real *in = b->ghost_count ? (const dem_real *)demi_slab_inbox(s, b, 0)->bytes
        : 0;
    int k;
    for (k = 0; k < b->ghost_count; k++, in += up + own) {
        const int i = b->ghost[k];
        if (own) memcpy(w->bodies.reals + own*(size_t)i, in + up, own*sizeof *in);
        if (w->bodies.booked) memcpy(w->bodies.late + 4*i, in + up - 3, three);
        memcpy(w->bodies.pos + 4*i, in, three);
        memcpy(w->bodies.vel + 4*i, in + 3, three);
        w->bodies.inv_mass[i] = b->ghost_inv[2*k];
        w->bodies.inv_inertia[i] = b->ghost_inv[2*k + 1];
        if (up < 15) continue;
        memcpy(w->bodies.spin + 4*i, in + 6, three);
        memcpy(w->bodies.half_vel + 4*i, in + 9, three);
        memcpy(w->bodies.half_spin + 4*i, in + 12, three);
        if (!w->bodies.orienting) continue;
        memcpy(w->bodies.orient + 4*i, in + 15, 4*sizeof(dem_real));
        if (w->bodies.centres_valid && demi_shape_of(w, i) && demi_shape_of(w, i)->count)
            demi_centres_rotate(w, i);
    }
}
/* The near list, where it is due. */
static void demi_slab_near(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    demi_slab_receive(s, b);
    if (!demi_near_due(w)) return;
    demi_near_choose(w);
    if (!demi_near_make(w, 0)) b->result = demi_no_memory(w, "dem_slabs_step");
}
/* 3 touch. Where bodies are not spheres it may run out of room; all agree before any force is
   worked out, since memory follows a step once. Else there is room, see demi_kept_room. */
static void demi_slab_touch(dem_slabs *s, demi_slab *b) {
    demi_slab_receive(s, b);
    if (!demi_touch(b->world)) b->result = demi_no_memory(b->world, "dem_slabs_step");
}
/* 4 respond, 5 gather, here; forces on ghosts go into the lower outbox. */
static void demi_slab_forces(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    const size_t three = 3*sizeof(dem_real), down = demi_slab_pushes(w);
    const size_t own = (size_t)w->bodies.real_count;
    dem_real *out = (dem_real *)b->out[0].bytes;
    int k, d, finite = 1;
    if (!w->bodies.orienting) demi_slab_touch(s, b);
    demi_forces(w);
    for (k = 0; k < b->ghost_count; k++, out += down + own) {
        if (own) memcpy(out + down, w->bodies.rates + own*(size_t)b->ghost[k], own*sizeof *out);
        memcpy(out, w->bodies.force + 4*b->ghost[k], three);
        if (down == 6) memcpy(out + 3, w->bodies.torque + 4*b->ghost[k], three);
    }
    if (!w->stage.forces_valid) return;               /* only looking */
    for (d = 0; d < w->domain_count && demi_own(w); d++)
        finite &= w->domains[d].check < 1e300;
    if (!finite || !(demi_overlap(w) < 1)) b->result = demi_unstable(w);
}
/* Forces on own grains that are ghosts above come back, in the order in which they were lent. */
static void demi_slab_add(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    const size_t down = demi_slab_pushes(w), own = (size_t)w->bodies.real_count;
    const dem_real *in = b->lent_count ? (const dem_real *)demi_slab_inbox(s, b, 1)->bytes
        : 0;
    size_t r;
    int k, e;
    for (k = 0; k < b->lent_count; k++, in += down + own) {
        for (e = 0; e < 3; e++) {
            w->bodies.force[4*b->lent[k] + e] += in[e];
            if (down == 6) w->bodies.torque[4*b->lent[k] + e] += in[3 + e];
        }
        for (r = 0; r < own; r++) w->bodies.rates[own*(size_t)b->lent[k] + r] += in[down + r];
    }
}
static void demi_slab_gain(dem_slabs *s, demi_slab *b) { (void)s; demi_reals_gain(b->world); }
/* near: some slab's near list may have to be made anew first. */
static dem_result demi_slabs_forces(dem_slabs *s, int near) {
    dem_result result = DEM_OK;
    if (s->count > 1) {
        demi_slabs_phase(s, demi_slab_send);
        result = demi_slabs_exchange(s, DEMI_UP, 1);
        if (result != DEM_OK) return result;
    }
    if (near) {
        demi_slabs_phase(s, demi_slab_near);
        result = demi_slabs_agree(s, 0, 0);
        if (result != DEM_OK) return result;
    }
    if (s->slabs[0].world->bodies.orienting) {
        demi_slabs_phase(s, demi_slab_touch);
        result = demi_slabs_agree(s, 0, 0);
        if (result != DEM_OK) return result;
    }
    demi_slabs_phase(s, demi_slab_forces);
    if (s->count == 1) return DEM_OK;
    result = demi_slabs_exchange(s, DEMI_DOWN, 1);
    if (result == DEM_OK) demi_slabs_phase(s, demi_slab_add);
    return result;
}

static void demi_slab_finish(dem_slabs *s, demi_slab *b) { (void)s; demi_finish(b->world); }
static void demi_slab_prime(dem_slabs *s, demi_slab *b) {
    (void)s;
    demi_finish(b->world);
    demi_prime(b->world);
}
static void demi_slab_refresh(dem_slabs *s, demi_slab *b) {
    (void)s;
    demi_kernel_choose(b->world);
    b->world->stage.forces_valid = 0;
}
static void demi_slab_sample(dem_slabs *s, demi_slab *b) {
    (void)s;
    demi_fields_sample(b->world);
}

/* As demi_refresh: forces at the present time, by a new list where somebody has none. */
static dem_result demi_slabs_refresh(dem_slabs *s) {
    dem_result result;
    double stale = !s->head.stage.list_valid;
    int k;
    demi_slabs_phase(s, demi_slab_finish);
    for (k = 0; k < s->local; k++) stale = DEMI_MAX(stale, !s->slabs[k].world->stage.list_valid);
    result = demi_slabs_agree(s, &stale, 1);
    if (result == DEM_OK && stale > 0) result = demi_slabs_rebuild(s);
    if (result != DEM_OK) return result;
    demi_slabs_phase(s, demi_slab_refresh);
    result = demi_slabs_forces(s, 0);
    if (result != DEM_OK) return result;
    for (k = 0; k < s->local; k++) s->slabs[k].world->stage.forces_valid = 1;
    s->head.stage.forces_valid = 1;
    return DEM_OK;
}

/* One step, in the order of demi_step_once. */
static dem_result demi_slabs_step_once(dem_slabs *s) {
    dem_world *h = &s->head;
    const dem_world *first = s->slabs[0].world;
    /* speed, list stale, walls' reach, last change; near lists' creep, age over what they allow;
       reach */
    double flags[7] = {0, 0, 0, 0, -1e300, -1e300, 0};
    const double dt = (double)h->clock.dt;
    dem_result result;
    int k, near, search;
    demi_slabs_phase(s, demi_slab_move);
    for (k = 0; k < s->local; k++) {
        const dem_world *w = s->slabs[k].world;
        flags[0] = DEMI_MAX(flags[0], w->booked.speed_max);
        flags[1] = DEMI_MAX(flags[1], !w->stage.list_valid);
        flags[3] = DEMI_MAX(flags[3], w->margin.last_change);
        flags[4] = DEMI_MAX(flags[4],
                            w->margin.creep + 2*w->margin.change*dt - w->margin.slack);
        flags[5] = DEMI_MAX(flags[5], w->margin.age + dt - w->margin.span*(1 - 1e-9));
        flags[6] = DEMI_MAX(flags[6], w->margin.step_gone);
    }
    flags[2] = first->margin.walls_gone;
    if (!h->stage.moved) {
        h->stage.moved = 1;
        h->clock.time = first->clock.time;
        h->clock.since = first->clock.since;
        h->clock.steps++;
        demi_slabs_poses(s);
        result = demi_slabs_agree(s, flags, 7);
        h->booked.speed_max = flags[0];
        h->margin.gone += flags[6];
        for (k = 0; k < s->local; k++) demi_near_pass(s->slabs[k].world, flags[3]);
        h->near_due = flags[4] + 2*flags[3]*dt > -1e-6*h->margin.skin || flags[5] > -1e-6*dt;
    } else result = demi_slabs_agree(s, flags, 7);
    if (result != DEM_OK) return result;
    near = s->count == 1 || h->near_due;        /* each looks for itself again */
    if (s->count == 1) h->margin.gone = first->margin.gone;
    h->margin.walls_gone = flags[2];
    for (k = 0; k < s->local && s->count > 1; k++) {           /* what lists count on */
        s->slabs[k].world->margin.gone = h->margin.gone;
        s->slabs[k].world->margin.walls_gone = h->margin.walls_gone;
    }
    search = flags[1] > 0 || !h->stage.list_valid || h->margin.skin <= 0 ||
             2*h->margin.gone > h->margin.skin ||
             h->margin.gone + h->margin.walls_gone > h->margin.skin;
    if (first->outlet_count && (search || h->clock.steps%DEMI_OUTLET_REST == 0)) {
        result = demi_slabs_outlets(s, &search);
        if (result != DEM_OK) return result;
    }
    if (search) {
        result = demi_slabs_rebuild(s);
        if (result != DEM_OK) return result;
        if (demi_outgrown(h)) h->stage.dt_valid = 0;
        near = 0;
    }
    result = demi_slabs_forces(s, near);
    if (result != DEM_OK) return result;
    demi_slabs_phase(s, demi_slab_gain);
    h->stage.moved = 0;
    return DEM_OK;
}
