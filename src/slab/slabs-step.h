/* ---------------------------------------------------------------------------------------------
   >>slabs-step
   Communication of slabs in a step: the functions of their team (demi_team). Reductions over
   processes and exchanges between neighbours; for a rebuild the borders, which balance the load,
   the migration of grains and the choice of ghosts; in every step the states of ghosts, sent up,
   and the forces on ghosts, sent down. Owns borders, outboxes and inboxes, and the lists of ghosts.
   --------------------------------------------------------------------------------------------- */

/* Runs the present phase for slab k of this process and adds the time that it takes. */
static void demi_slab_task(dem_world *w, int k) {
    dem_slabs *s = (dem_slabs *)(void *)w;      /* the head comes first */
    const double begun = demi_clock();
    s->phase(s, &s->slabs[k]);
    s->slabs[k].seconds += demi_clock() - begun;
}
/* Runs a phase for all slabs of this process, in parallel. */
static void demi_slabs_phase(dem_slabs *s, void (*phase)(dem_slabs *, demi_slab *)) {
    s->phase = phase;
    demi_parallel(&s->head, s->head.desc.threads, s->local, 0, demi_slab_task);
}

/* True if there is a slab above (side 1) or below (side 0). */
static int demi_slab_has(const dem_slabs *s, const demi_slab *b, int side) {
    return s->ring || (side ? b->index + 1 < s->count : b->index > 0);
}
/* Returns the message that the neighbour on one side has sent here: its outbox if it is in this
   process, otherwise the inbox. */
static const demi_message *demi_slab_inbox(const dem_slabs *s, const demi_slab *b, int side) {
    int k = b->index - s->first + (side ? 1 : -1);
    if (s->local == s->count) k = (k + s->count)%s->count;
    return k >= 0 && k < s->local ? &s->slabs[k].out[!side] : &b->in[side];
}

/* Fails because the transport has failed. Processes may be out of step from here on, so later calls
   fail as well (demi_slabs_usable). */
static dem_result demi_slabs_transport_failed(dem_slabs *s, const char *what, int answer) {
    s->broken = 1;
    return demi_fail(&s->head, DEM_ERROR_STOPPED, "dem_slabs_step: %s of the transport returned "
                     "%d, must be 0; the slabs cannot continue: repair the connection and create "
                     "them again from the last collected world or checkpoint", what, answer);
}
/* Replaces `count` values by their maxima over processes or, if `sum`, by their sums, which must be
   sums of whole numbers. */
static dem_result demi_slabs_reduce(dem_slabs *s, double *values, int count, int sum) {
    int answer;
    if (s->local == s->count) return DEM_OK;
    DEMI_USER(&s->head, "dem_slabs_step", 1, answer = s->desc.transport.reduce_fn(
        values, count, sum, s->desc.transport.user))
    return answer ? demi_slabs_transport_failed(s, "reduce_fn", answer) : DEM_OK;
}

/* `agree` of demi_team. Returns the results of the phases since the last call: DEM_OK, or in all
   processes the same failure, that of the lowest slab concerned; only its process has the full
   message. Replaces `count` flags (at most 7) by their maxima over processes. */
static dem_result demi_slabs_agree(dem_world *h, double *flags, int count) {
    dem_slabs *s = (dem_slabs *)(void *)h;
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
/* Runs a phase on all slabs. Returns DEM_OK, or the error of a slab that failed. */
static dem_result demi_slabs_try(dem_slabs *s, void (*phase)(dem_slabs *, demi_slab *)) {
    demi_slabs_phase(s, phase);
    return demi_slabs_agree(&s->head, 0, 0);
}
/* Runs the present task on a slab, unless it has failed since the last agreement. */
static void demi_slab_run(dem_slabs *s, demi_slab *b) {
    if (b->result == DEM_OK) b->result = s->task(b->world);
}
/* `all` of demi_team. */
static dem_result demi_slabs_all(dem_world *h, dem_result (*task)(dem_world *member)) {
    dem_slabs *s = (dem_slabs *)(void *)h;
    s->task = task;
    demi_slabs_phase(s, demi_slab_run);
    return DEM_OK;
}

/* `sum` of demi_team. Maxima over processes pass on the numbers of each slab, so that the bits of
   their sum do not depend on processes. count: at most DEMI_SLAB_BINS. */
static dem_result demi_slabs_sum(dem_world *h, void (*part)(const dem_world *, int, double *),
                                 int of, double *sums, int count) {
    dem_slabs *s = (dem_slabs *)(void *)h;
    double *v = s->values;
    dem_result result;
    int i, k;
    for (i = 0; i < s->count*count; i++) v[i] = -DBL_MAX;
    for (k = 0; k < s->local; k++) part(s->slabs[k].world, of, v + (s->first + k)*count);
    result = demi_slabs_reduce(s, v, s->count*count, 0);
    for (i = 0; i < count; i++) sums[i] = 0;
    for (i = 0; i < s->count*count; i++) sums[i%count] += v[i];
    return result;
}
/* Exchanges the outboxes that lead to other processes, in the directions `ways` (DEMI_UP,
   DEMI_DOWN or both). sized: 1 if the sizes of the inboxes are set, because the receivers know what
   will arrive; 0: the sizes are exchanged first and the inboxes get room. */
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
        DEMI_USER(&s->head, "dem_slabs_step", 1, answer = t->exchange_fn(
            &send[0], 8, &get[0], 8, &send[1], 8, &get[1], 8, t->user))
        if (answer) return demi_slabs_transport_failed(s, "exchange_fn", answer);
        if (!DEMI_GROW(low->world, low->in[0].bytes, (size_t)get[0]) ||
            !DEMI_GROW(top->world, top->in[1].bytes, (size_t)get[1]))
            low->result = demi_no_memory(low->world, "dem_slabs_step");
        result = demi_slabs_agree(&s->head, 0, 0);
        if (result != DEM_OK) return result;
        low->in[0].size = (size_t)get[0];
        top->in[1].size = (size_t)get[1];
    }
    DEMI_USER(&s->head, "dem_slabs_step", 1, answer = t->exchange_fn(
        low->out[0].bytes, (size_t)send[0], low->in[0].bytes, (size_t)get[0],
        top->out[1].bytes, (size_t)send[1], top->in[1].bytes, (size_t)get[1], t->user))
    return answer ? demi_slabs_transport_failed(s, "exchange_fn", answer) : DEM_OK;
}

/* --- borders --- */

/* Sets the inner borders so that each slab has the same part of the weight in `bins`, n equal
   intervals from lo to hi, m. */
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
/* Moves borders until no slab is thinner than s->cut. The outermost slabs of an open axis have no
   outer border. */
static void demi_slabs_space(dem_slabs *s) {
    double *b = s->borders;
    int j;
    for (j = s->ring ? 1 : 2; j < s->count; j++) b[j] = DEMI_MAX(b[j], b[j - 1] + s->cut);
    for (j = s->count - 1; s->ring && j > 0; j--) b[j] = DEMI_MIN(b[j], b[j + 1] - s->cut);
}
/* Adds `weight` for each own grain of a slab to n bins from lo to hi, m. */
static void demi_slabs_bin(const dem_slabs *s, const dem_world *w, double weight, double *bins,
                           int n, double lo, double hi) {
    int i;
    for (i = 0; i < w->bodies.count; i++) {
        const double t = ((double)w->bodies.pos[4*i + s->axis] - lo)/(hi - lo)*n;
        if (!demi_is_ghost(w, i)) bins[t > 0 ? t < n ? (int)t : n - 1 : 0] += weight;
    }
}
/* Updates the highest position of own grains along the axis, m, in ends[0], and minus the lowest in
   ends[1]: one reduction of maxima finds both. */
static void demi_slabs_extent(const dem_slabs *s, const dem_world *w, double *ends) {
    int i;
    for (i = 0; i < w->bodies.count; i++) {
        const double x = (double)w->bodies.pos[4*i + s->axis];
        if (demi_is_ghost(w, i)) continue;
        ends[0] = DEMI_MAX(ends[0], x);
        ends[1] = DEMI_MAX(ends[1], -x);
    }
}
/* Load balancing: moves the borders if the counted work of the busiest slab exceeds the mean too
   much (desc.balance). The weight of a grain is the mean work of a grain of its slab, in sixteenths
   and rounded, because sums of whole numbers are the same in any order. */
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

/* Chooses the skin of a rebuild from totals over all slabs, by the cost model of a single world
   (demi_skin_choose), and sets the smallest thickness of a slab, s->cut. Fails if a period is too
   short for so many slabs. */
static dem_result demi_slabs_skin(dem_slabs *s) {
    double sums[3] = {0, 0, 0}, radii[3] = {0, -1e300, 0};    /* largest, -smallest; span */
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
            const double r = (double)demi_radius(w, i);
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
    h->margin.skin = (double)(dem_real)h->margin.skin;        /* rounded as in the slabs */
    s->cut = (2*radii[0] + (double)demi_cover(h))*(1 + 1e-6);  /* rounding loses no ghost */
    if (s->ring && s->cut*s->count > s->period)
        return demi_refuse(h, "dem_slabs_step", "%d slabs in a period of %g m are %g m thick, must "
                           "be at least %g m (the largest diameter and the skin%s); use at most %d "
                           "slabs or a smaller skin", s->count, s->period, s->period/s->count,
                           s->cut, h->margin.reach > 0 ? " and the law's range" : "",
                           (int)(s->period/s->cut));
    return DEM_OK;
}

/* --- a rebuild, phase by phase --- */

/* Files the contact histories of a slab and removes its ghosts. */
static void demi_slab_drop(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    int i;
    (void)s;
    if (!demi_list_drop(w)) { b->result = demi_no_memory(w, "dem_slabs_step"); return; }
    for (i = w->bodies.count - 1; i >= 0; i--) if (demi_is_ghost(w, i)) demi_grain_forget(w, i);
    b->ghost_count = b->lent_count = 0;
}
/* Returns the side to which a grain at x (m, along the axis) belongs: -1 below, 0 here, 1 above. A
   grain below the first border stays if x + period is rounded to the last border or beyond. */
static int demi_slab_side(const dem_slabs *s, const demi_slab *b, dem_real x) {
    if ((double)x < s->borders[b->index])
        return b->index || (double)(x + (dem_real)s->period) < s->borders[s->count] ? -1 : 0;
    return (double)x >= s->borders[b->index + 1];
}
/* Returns what is added to positions that are sent up (side 1) or down (side 0), m: a period
   or 0. */
static dem_real demi_slab_shift(const dem_slabs *s, const demi_slab *b, int side) {
    if (side && b->index == s->count - 1) return -(dem_real)s->period;
    return !side && b->index == 0 ? (dem_real)s->period : 0;
}
/* Packs the grains that have crossed a border into the outboxes. They also stay here until their
   receivers have reserved memory. */
static void demi_slab_leave(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    int i, side, ok = 1, going[2] = {0, 0};
    for (i = 0; i < w->bodies.count; i++) {
        side = demi_slab_side(s, b, w->bodies.pos[4*i + s->axis]);
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
/* Returns the head of the message from one side, and sets *grains to the begin of its grains; zeros
   if there is no slab on that side. */
static demi_message_head demi_slab_head(const dem_slabs *s, const demi_slab *b, int side,
                                       const char **grains) {
    demi_message_head head = {0, 0, 0, 0};
    if (demi_slab_has(s, b, side)) {
        *grains = demi_slab_inbox(s, b, side)->bytes;
        demi_unpack(grains, &head, sizeof head);
    }
    return head;
}
/* Reserves memory for all that arrives from both sides, before anything leaves. */
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
/* Removes the grains that leave, and appends those that arrive. Nothing can fail any more. */
static void demi_slab_migrate(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    int i, side;
    for (i = w->bodies.count - 1; i >= 0; i--)
        if (demi_slab_side(s, b, w->bodies.pos[4*i + s->axis])) demi_grain_forget(w, i);
    b->migrated += (uint64_t)b->leavers;
    for (side = 0; side < 2; side++) {
        const char *from = 0;
        const demi_message_head h = demi_slab_head(s, b, side, &from);
        for (i = 0; i < h.grains; i++) demi_grain_append(w, &from);
        demi_filed_unpack(w, b->add, &h, from);
    }
}
/* Chooses the grains that become ghosts in the upper neighbour, all that are near enough to the
   upper border to be candidates with a grain beyond it, and packs them. */
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
        const double x = (double)w->bodies.pos[4*i + s->axis], r = (double)demi_radius(w, i);
        if (!(x + s->cut - (double)s->head.effects.radius_max +
              r > s->borders[b->index + 1])) continue;
        w->bodies.ghost[w->bodies.slot[i]] = DEMI_GHOST_ABOVE;
        b->lent[n++] = (int32_t)w->bodies.slot[i];
    }
    if (!demi_pack(w, w, w->bodies.ghost, DEMI_GHOST_ABOVE, 0, s->axis, demi_slab_shift(s, b, 1),
                   &b->out[1])) b->result = demi_no_memory(w, "dem_slabs_step");
    for (i = 0; i < n; i++) w->bodies.ghost[b->lent[i]] = 0;
    b->lent_count = n;
}
/* --- the record (demi_record) that owners lend to ghosts: the state of a body that the laws in
   force
       use. Its position comes first --- */
static size_t demi_lent_size(const dem_world *w) {
    const size_t state = w->bodies.orienting ? 19 : demi_spins(w) ? 15 : 6;
    return (state + (w->bodies.booked ? 3 : 0) + (size_t)w->bodies.real_count)*sizeof(dem_real);
}
/* Lists the arrays of the record, in order: the distance between two bodies, and how many reals of
   each body are sent. Returns the number of arrays. */
static int demi_lent_arrays(const dem_world *w, dem_real *array[8], int stride[8], int count[8]) {
    const demi_bodies *b = &w->bodies;
    int n = 0;
#define DEMI_TOLD(of, step, reals) (array[n] = (of), stride[n] = (step), count[n++] = (reals))
    DEMI_TOLD(b->pos, 4, 3);
    DEMI_TOLD(b->vel, 4, 3);
    if (demi_spins(w) || b->orienting) {
        DEMI_TOLD(b->spin, 4, 3);
        DEMI_TOLD(b->half_vel, 4, 3);
        DEMI_TOLD(b->half_spin, 4, 3);
    }
    if (b->orienting) DEMI_TOLD(b->orient, 4, 4);
    if (b->booked) DEMI_TOLD(b->late, 4, 3);
    if (b->real_count) DEMI_TOLD(b->reals, b->real_count, b->real_count);
#undef DEMI_TOLD
    return n;
}
static void demi_lent_put(const dem_world *w, int i, char *to) {
    dem_real *array[8];
    int stride[8], count[8], k;
    const int n = demi_lent_arrays(w, array, stride, count);
    for (k = 0; k < n; k++) {
        memcpy(to, array[k] + stride[k]*i, (size_t)count[k]*sizeof(dem_real));
        to += (size_t)count[k]*sizeof(dem_real);
    }
}
static void demi_lent_take(dem_world *w, int i, const char *from) {
    dem_real *array[8];
    int stride[8], count[8], k;
    const int n = demi_lent_arrays(w, array, stride, count);
    for (k = 0; k < n; k++)
        demi_unpack(&from, array[k] + stride[k]*i, (size_t)count[k]*sizeof(dem_real));
    if (w->bodies.orienting && w->bodies.centres_valid) demi_centres_rotate(w, &i, 1);
}
static const demi_record demi_lent = {demi_lent_size, demi_lent_put, demi_lent_take};

/* Up: owners put the states of lent grains into the outbox, shifted by a period where the ring
   closes. Ghosts take them, and get back the mass that demi_slab_rest has removed. */
static void demi_slab_put_up(dem_slabs *s, demi_slab *b) {
    const size_t size = demi_lent.size(b->world);
    const dem_real shift = demi_slab_shift(s, b, 1);
    char *to = b->out[1].bytes;
    dem_real x;
    int k;
    b->out[1].size = (size_t)b->lent_count*size;
    b->in[0].size = (size_t)b->ghost_count*size;
    for (k = 0; k < b->lent_count; k++, to += size) {
        demi_lent.put(b->world, b->lent[k], to);
        memcpy(&x, to + (size_t)s->axis*sizeof x, sizeof x);
        x += shift;
        memcpy(to + (size_t)s->axis*sizeof x, &x, sizeof x);
    }
}
static void demi_slab_take_up(dem_slabs *s, demi_slab *b) {
    const size_t size = demi_lent.size(b->world);
    const char *from = b->ghost_count ? demi_slab_inbox(s, b, 0)->bytes : 0;
    int k;
    for (k = 0; k < b->ghost_count; k++, from += size) {
        demi_lent.take(b->world, b->ghost[k], from);
        b->world->bodies.inv_mass[b->ghost[k]] = b->ghost_inv[2*k];
        b->world->bodies.inv_inertia[b->ghost[k]] = b->ghost_inv[2*k + 1];
    }
}
/* `lend` of demi_team. */
static dem_result demi_slabs_lend(dem_world *h) {
    dem_slabs *s = (dem_slabs *)(void *)h;
    dem_result result;
    if (s->count == 1) return DEM_OK;
    demi_slabs_phase(s, demi_slab_put_up);
    result = demi_slabs_exchange(s, DEMI_UP, 1);
    if (result == DEM_OK) demi_slabs_phase(s, demi_slab_take_up);
    return result;
}
/* Down: the record s->record of all ghosts is put into the outbox. Owners take it in the order in
   which they lent. demi_slabs_give: `give` of demi_team. */
static void demi_slab_put_down(dem_slabs *s, demi_slab *b) {
    const size_t size = s->record->size(b->world);
    int k;
    b->out[0].size = (size_t)b->ghost_count*size;
    b->in[1].size = (size_t)b->lent_count*size;
    for (k = 0; k < b->ghost_count; k++)
        s->record->put(b->world, b->ghost[k], b->out[0].bytes + (size_t)k*size);
}
static void demi_slab_take_down(dem_slabs *s, demi_slab *b) {
    const size_t size = s->record->size(b->world);
    const char *from = b->lent_count ? demi_slab_inbox(s, b, 1)->bytes : 0;
    int k;
    for (k = 0; k < b->lent_count; k++)
        s->record->take(b->world, b->lent[k], from + (size_t)k*size);
}
static dem_result demi_slabs_give(dem_world *h, const demi_record *what) {
    dem_slabs *s = (dem_slabs *)(void *)h;
    dem_result result;
    if (s->count == 1) return DEM_OK;
    s->record = what;
    demi_slabs_phase(s, demi_slab_put_down);
    result = demi_slabs_exchange(s, DEMI_DOWN, 1);
    if (result == DEM_OK) demi_slabs_phase(s, demi_slab_take_down);
    return result;
}
/* `rest` of demi_team: during a move ghosts are at rest and have no inverse mass, because their
   owner moves them. */
static void demi_slab_rest(dem_world *w) {
    const dem_slabs *s = (const dem_slabs *)(void *)w->team->head;
    const demi_slab *b = &s->slabs[w->member];
    const dem_vec3 none = demi_v(0, 0, 0);
    int k;
    for (k = 0; k < b->ghost_count; k++) {
        const int i = b->ghost[k];
        w->bodies.inv_mass[i] = w->bodies.inv_inertia[i] = 0;
        demi_put(w->bodies.vel + 4*i, none);
        demi_put(w->bodies.half_vel + 4*i, none);
        demi_put(w->bodies.spin + 4*i, none);
        demi_put(w->bodies.half_spin + 4*i, none);
        demi_put(w->bodies.force + 4*i, none);
        demi_put(w->bodies.torque + 4*i, none);
        if (w->bodies.backward) demi_put(w->bodies.last_pos + 4*i, demi_at(w->bodies.pos + 4*i));
    }
}

/* --- a new list --- */

/* Appends the ghosts and rebuilds the lists as in any world, with the skin that all slabs share. */
static void demi_slab_list(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    const char *from = 0;
    const demi_message_head h = demi_slab_head(s, b, 0, &from);
    int i, d, ok;
    ok = demi_bodies_reserve(w, (size_t)w->bodies.count + (size_t)h.grains) &&
         DEMI_GROW(w, b->ghost, (size_t)h.grains) && DEMI_GROW(w, b->ghost_inv, 2*(size_t)h.grains);
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
    for (i = 0; i < b->ghost_count; i++) b->ghost[i] = w->bodies.slot_index[b->ghost[i]];
    for (i = 0; i < b->lent_count; i++) b->lent[i] = w->bodies.slot_index[b->lent[i]];
    b->work = 4.0*w->bodies.count;
    for (d = 0; d < w->domain_count; d++)
        b->work += w->domains[d].own + w->domains[d].cross + w->domains[d].walls;
}
/* Reserves, after all slabs have read their messages, the room that outboxes and inboxes need in
   steps, so that no exchange in a step runs out of memory: up for the states of ghosts, down for
   forces or for the data from which the time step is checked. */
static void demi_slab_settle(dem_slabs *s, demi_slab *b) {
    dem_world *w = b->world;
    const size_t up = demi_lent.size(w);
    const size_t down = DEMI_MAX(demi_pushes_size(w), sizeof(demi_press_whole));
    (void)s;
    if (!DEMI_GROW(w, b->in[0].bytes, (size_t)b->ghost_count*up) ||
        !DEMI_GROW(w, b->in[1].bytes, (size_t)b->lent_count*down) ||
        !DEMI_GROW(w, b->out[0].bytes, (size_t)b->ghost_count*down) ||
        !DEMI_GROW(w, b->out[1].bytes, (size_t)b->lent_count*up))
        b->result = demi_no_memory(w, "dem_slabs_step");
}

/* Sends grains to the slabs to which they belong. In each round a grain moves on by one slab; the
   last round finds none that leaves. */
static dem_result demi_slabs_migrate(dem_slabs *s) {
    dem_result result;
    for (;;) {
        double leavers = 0;
        int k;
        demi_slabs_phase(s, demi_slab_leave);
        for (k = 0; k < s->local; k++) leavers = DEMI_MAX(leavers, s->slabs[k].leavers);
        result = demi_slabs_agree(&s->head, &leavers, 1);
        if (result != DEM_OK || !(leavers > 0)) return result;
        result = demi_slabs_exchange(s, DEMI_UP | DEMI_DOWN, 0);
        if (result != DEM_OK) return result;
        result = demi_slabs_try(s, demi_slab_room);
        if (result != DEM_OK) return result;
        demi_slabs_phase(s, demi_slab_migrate);
    }
}
/* Makes the surfaces of the first slab again if they are outdated, and shares them with the others.
   If memory runs out, the next agreement fails. */
static void demi_slabs_surfaces(dem_slabs *s) {
    dem_world *first = s->slabs[0].world;
    int k, ok = 1;
    for (k = 1; k < s->local; k++)              /* while those that they share still exist */
        if (!s->slabs[k].world->facets_valid) demi_surfaces_free(s->slabs[k].world);
    for (k = 0; k < s->local && ok; k++) {
        dem_world *w = s->slabs[k].world;
        if (!w->facets_valid) ok = k ? demi_surfaces_share(w, first) : demi_surfaces_make(first);
        if (!ok) s->slabs[k].result = demi_no_memory(w, "dem_slabs_step");
    }
}
/* `rebuild` of demi_team. After DEM_ERROR_MEMORY every grain is still in exactly one slab, with its
   contact history; the next call starts again. */
static dem_result demi_slabs_rebuild(dem_world *h) {
    dem_slabs *s = (dem_slabs *)(void *)h;
    const double skin_before = h->margin.skin_auto;
    dem_result result;
    demi_list_outdated(h);
    demi_slabs_surfaces(s);
    result = demi_slabs_try(s, demi_slab_drop);
    if (s->count > 1) {
        if (result == DEM_OK) result = demi_slabs_skin(s);
        if (result == DEM_OK) result = demi_slabs_balance(s);
        if (result == DEM_OK) { demi_slabs_space(s); result = demi_slabs_migrate(s); }
        if (result == DEM_OK) result = demi_slabs_try(s, demi_slab_invite);
        if (result == DEM_OK) result = demi_slabs_exchange(s, DEMI_UP, 0);
    }
    if (result == DEM_OK) result = demi_slabs_try(s, demi_slab_list);
    if (result == DEM_OK) result = demi_slabs_try(s, demi_slab_settle);
    if (result != DEM_OK) { h->margin.skin_auto = skin_before; return result; }
    if (s->count == 1) {
        h->margin.skin = s->slabs[0].world->margin.skin;
        h->effects.radius_min = s->slabs[0].world->effects.radius_min;
    }
    demi_lists_made(h);
    return DEM_OK;
}

/* `grades` of demi_team: replaces the data on which the choice of a time step depends (demi_grades)
   by those of all processes. */
static dem_result demi_slabs_grades(dem_world *h, demi_grades *g) {
    dem_slabs *s = (dem_slabs *)(void *)h;
    const int m = h->material_count;
    double *v = s->values, *end = v + 2*m;
    dem_result result;
    int i;
    for (i = 0; i < m; i++) {
        v[i] = g->many[i] > 0 ? -g->smallest[i] : -1e300;
        v[m + i] = g->peg[i];
    }
    end[0] = g->speed; end[1] = g->spin; end[2] = -g->lo; end[3] = g->hi;
    result = demi_slabs_reduce(s, v, 2*m + 4, 0);
    for (i = 0; i < m; i++) {
        g->smallest[i] = v[i] > -1e300 ? -v[i] : 0;
        g->peg[i] = v[m + i];
        v[i] = g->many[i];
    }
    g->speed = end[0]; g->spin = end[1]; g->lo = -end[2]; g->hi = end[3];
    v[m] = g->bodies;
    if (result == DEM_OK) result = demi_slabs_reduce(s, v, m + 1, 1);
    memcpy(g->many, v, (size_t)m*sizeof *v);
    g->bodies = v[m];
    return result;
}
