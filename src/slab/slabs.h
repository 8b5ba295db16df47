/* ---------------------------------------------------------------------------------------------
   >>slabs
   Domain decomposition along one axis, after [ALK07] 3.5. Each slab is a world with all walls of
   the scene, its own grains, and ghost particles: copies of those grains of its lower neighbour
   that may touch its own. Slots are those of the whole scene, so that contact history, which is
   filed by slot, fits its pair in any slab. Slabs are the members of a team (>>team) and use the
   step of a single world (>>step):
       move     each slab moves its own grains; ghosts rest
       agree    are new candidate lists or pruned lists due? one maximum over all slabs
       lend     the states of grains are sent up to their ghosts
       respond  contacts of own grains with own grains, ghosts and walls; the contacts of two ghosts
                belong to the slab that owns them
       give     the forces on ghosts are sent down to their owners, which add them
   ([ALK07] sends copies down; this is the mirror image.) When lists are rebuilt, grains that have
   crossed a border migrate, each with a copy of all contact history that names it. Then new ghosts
   are chosen. The slab that computes a pair next always has its history: it is the upper one of the
   two that own the bodies, and the body that it owns was in the slab that has the history, or
   passes through that slab on its way. A slab is never thinner than the largest distance of two
   candidates (two of the largest radii, the skin and the range of the law), so only neighbours
   interact.

   Work is divided into phases: one function for each slab, called by demi_parallel for all slabs of
   this process. In a phase a slab writes only to itself. It may read its neighbours' outboxes,
   which then do not change. Between phases, outboxes that lead to other processes are exchanged.
   Reductions over processes are maxima, or sums of whole numbers, which are exact in any order. So
   the bits of a result depend on the number of slabs, but not on threads or processes.

   In each process only the walls of the first slab move. Their poses are copied to the other slabs
   (demi_walls_follow), so that a user-defined motion is called as often as without slabs.

   This part owns messages: it packs grains with their contact history and unpacks them.
   --------------------------------------------------------------------------------------------- */
/* Copy, or set to 0, the fields that have any of the bits `uses` in `how`. */
static void demi_rows_copy(const demi_field_row *r, void *to, const void *from, int uses) {
    for (; r->name; r++)
        if (r->how & uses) memcpy((char *)to + r->offset, (const char *)from + r->offset, r->size);
}
static void demi_rows_clear(const demi_field_row *r, void *item, int uses) {
    for (; r->name; r++) if (r->how & uses) memset((char *)item + r->offset, 0, r->size);
}
/* Adds the fields of one slab to those of the whole world: sums, maxima and bits. */
static void demi_rows_add(const demi_field_row *r, void *sum, const void *part) {
    size_t k;
    for (; r->name; r++) {
        void *to = (char *)sum + r->offset;
        const void *from = (const char *)part + r->offset;
        const size_t n = r->how & DEMI_SUM ? r->size/demi_row_item(r) : 0;
        for (k = 0; k < n; k++) switch (r->type) {
            case 'i': ((int32_t *)to)[k] += ((const int32_t *)from)[k]; break;
            case 'u': ((uint64_t *)to)[k] += ((const uint64_t *)from)[k]; break;
            case 'd': ((double *)to)[k] += ((const double *)from)[k]; break;
            default: ((dem_real *)to)[k] += ((const dem_real *)from)[k];
            }
        if (r->how & DEMI_LARGEST) *(double *)to = DEMI_MAX(*(double *)to, *(const double *)from);
        for (k = 0; k < r->size && r->how & DEMI_EITHER; k++)
            ((char *)to)[k] |= ((const char *)from)[k];
    }
}
/* Limits: number of slabs; bins per slab of the histogram from which borders are computed.
   Directions of an exchange. Values of bodies.ghost by slot: 0, or DEMI_GHOST; while messages are
   packed also one of the marks that follow. DEMI_ALL: the mark of all own grains, 0. */
enum { DEMI_SLABS = 1024, DEMI_SLAB_BINS = 32, DEMI_UP = 1, DEMI_DOWN = 2, DEMI_ALL = 0,
       DEMI_GHOST = 1, DEMI_GOES_DOWN = 2, DEMI_GOES_UP = 3, DEMI_GHOST_ABOVE = 4 };

/* A message, or an array of bytes that grows. */
typedef struct demi_message { char *bytes; size_t size; } demi_message;

typedef struct demi_slab {
    dem_world *world;
    int index;                     /* among the slabs of all processes */
    dem_result result;             /* of its phases since the last demi_slabs_agree */
    demi_message out[2];            /* to the lower, to the upper neighbour */
    demi_message in[2];             /* from them, if they are in another process */
    int32_t *lent, *ghost;         /* indices of own grains with a ghost above; of ghosts here, in
                                      the order in which the lower neighbour lends them */
    dem_real *ghost_inv;           /* x 2: 1/mass, 1/inertia of ghosts, 1/kg, 1/(kg m2) */
    int32_t *add;                  /* by row: new entries of contact history, demi_pairs_unpack */
    int lent_count, ghost_count, leavers;      /* entries of `lent`, of `ghost`; grains that leave
                                      in this round of migration */
    uint64_t bytes, migrated;      /* sent to neighbours; grains that left, since the beginning */
    double work, seconds;          /* as in dem_slab */
    demi_crowd crowd;              /* occupancy tree of the bodies near the region of a feed */
} demi_slab;

/* The slabs of one process. The head is a world without grains. It holds what the slabs share
   (time, time step, skin, errors), and stands for the whole scene in functions that need totals. It
   also owns the feeds: every process draws all new grains, so all processes draw the same. The head
   is the first field, so that a pointer to it is a pointer to its slabs. */
struct dem_slabs {
    dem_world head;
    dem_slabs_desc desc;
    /* axis 0 to 2; slabs in all processes; first slab of this process, number of its slabs; 1: the
       axis is periodic; 1: the transport has failed */
    int axis, count, first, local, ring, broken;
    double period, cut;            /* m: period along the axis; smallest thickness of a slab */
    double *borders;               /* m, count + 1; -1e300 and 1e300 at the ends of an open axis */
    double *values;                /* work array for reductions: DEMI_SLAB_BINS per slab, and 2 per
                                      material */
    demi_slab *slabs;              /* local */
    demi_domain total;             /* the head's only work group: totals for demi_skin_choose */
    demi_message mine, all;         /* for dem_slabs_collect: reports of this process, of all */
    uint32_t *known;               /* by slot: generation of the body that the slabs got when they
                                      were created, or from a feed; 0: none */
    int dealt, told, slots;        /* numbers of slots: when slabs were created; when they were last
                                      collected into the world; now */
    uint64_t border_moves;         /* how often the borders were moved */
    void (*phase)(struct dem_slabs *s, demi_slab *b);   /* running */
    demi_team team;
    dem_result (*task)(dem_world *member);      /* of the phase demi_slab_run */
    const demi_record *record;     /* of the exchange demi_slabs_give */
};

/* --- messages --- */

/* Appends bytes to a message. Returns 0 if memory ran out; the message is then unchanged. */
static int demi_message_put(dem_world *w, demi_message *p, const void *data, size_t size) {
    if (!DEMI_GROW(w, p->bytes, p->size + size)) return 0;
    if (size) memcpy(p->bytes + p->size, data, size);
    p->size += size;
    return 1;
}
/* Reads bytes of a message and moves *from behind them. */
static void demi_unpack(const char **from, void *to, size_t size) {
    if (!size) return;                          /* also if there is no message */
    memcpy(to, *from, size);
    *from += size;
}

/* --- a grain in a message: all its state, the rows of demi_body_arrays one after the other, its
       slot first --- */

/* Appends body i to a message. `shift`, m, is added to its positions along `axis`. host: the world
   whose memory is used. Returns 0 if memory ran out. */
static int demi_grain_put(dem_world *host, demi_message *out, const dem_world *w, int i, int axis,
                          dem_real shift) {
    int k;
    for (k = 0; k < DEMI_BODY_ARRAYS; k++) {
        const demi_body_array *a = &demi_body_arrays[k];
        dem_real place[4];
        if (!demi_keeps(w, a)) continue;
        if (a->what != DEMI_PLACES) {
            if (!demi_message_put(host, out, demi_datum(w, a, i), demi_item(w, a))) return 0;
            continue;
        }
        memcpy(place, demi_datum(w, a, i), sizeof place);
        place[axis] += shift;
        if (!demi_message_put(host, out, place, sizeof place)) return 0;
    }
    return 1;
}
/* Overwrites body i with the next grain of a message. */
static void demi_grain_unpack(dem_world *w, int i, const char **from) {
    int k;
    for (k = 0; k < DEMI_BODY_ARRAYS; k++) {
        const demi_body_array *a = &demi_body_arrays[k];
        if (demi_keeps(w, a))
            demi_unpack(from, demi_datum(w, a, i), demi_item(w, a));
    }
}
/* Returns the slot of the grain that begins here. */
static uint32_t demi_grain_slot(const char *from) {
    uint32_t slot;
    memcpy(&slot, from, sizeof slot);
    return slot;
}
/* Appends the next grain of a message to the bodies and returns its index. The caller has reserved
   memory. */
static int demi_grain_append(dem_world *w, const char **from) {
    const int i = w->bodies.count++;
    demi_grain_unpack(w, i, from);
    w->bodies.slot_index[w->bodies.slot[i]] = i;
    if (demi_shape_of(w, i)) w->bodies.shaped++;
    demi_lll_outdated(w);
    return i;
}
/* Removes a body from a slab that stays in the scene: another slab owns it. Its generation and the
   totals of the scene do not change, and its slot does not become free. */
static void demi_grain_forget(dem_world *w, int i) {
    const int slot = (int)w->bodies.slot[i], pending = w->bodies.slot_pending;
    demi_body_take_out(w, i);
    w->bodies.slot_pending = pending;
    w->bodies.slot_index[slot] = -1;
    w->bodies.slot_generation[slot]--;
    w->bodies.ghost[slot] = 0;
}

/* The begin of a message of grains: numbers of grains, of filed histories of two spheres, and of
   persistent contacts, which follow in this order; reals per history. */
typedef struct demi_message_head {
    int32_t grains, pairs, contacts, stride;
} demi_message_head;
/* Appends to `out` all bodies with this mark (marks: by slot) and, if `memory`, the histories and
   persistent contacts that name one of them (DEMI_ALL: all own bodies, and all histories and
   contacts that exist). `shift`, m, is added to positions along `axis`. Histories must be filed, by
   demi_list_drop or demi_carry_collect. host: the world whose memory is used. Returns 0 if memory
   ran out. */
static int demi_pack(dem_world *host, const dem_world *w, const uint8_t *marks, int mark,
                     int memory, int axis, dem_real shift, demi_message *out) {
    const size_t start = out->size;
    const int stride = w->filed.stride;
    demi_message_head head = {0, 0, 0, 0};
    int i, k, d, ok = demi_message_put(host, out, &head, sizeof head);
    head.stride = stride;
    for (i = 0; i < w->bodies.count && ok; i++) {
        if (marks[w->bodies.slot[i]] != mark) continue;
        ok = demi_grain_put(host, out, w, i, axis, shift);
        head.grains++;
    }
    for (i = 0; memory && w->filed.count && i < w->filed.rows && ok; i++)
        for (k = w->filed.start[i]; k < w->filed.start[i + 1] && ok; k++) {
            const int32_t p = w->filed.partner[k], other = p < 0 ? ~p : p, row = i;
            if (mark != DEMI_ALL && marks[row] != mark && marks[other] != mark) continue;
            ok = demi_message_put(host, out, &row, sizeof row) &&
                 demi_message_put(host, out, &p, sizeof p) &&
                 demi_message_put(host, out, &w->filed.part[k], sizeof p) &&
                 demi_message_put(host, out, w->filed.memory + (size_t)k*(size_t)stride,
                                 (size_t)stride*sizeof(dem_real));
            head.pairs++;
        }
    for (d = 0; memory && d < DEMI_DOMAINS && ok; d++)
        for (k = 0; k < w->domains[d].persistent && ok; k++) {
            demi_persistent c = demi_persistent_of(w, d)[k];
            demi_persistent_tidy(w, &c);
            if (w->stage.list_valid) {
                c.a = (int32_t)w->bodies.slot[c.a];
                if (c.b >= 0) c.b = (int32_t)w->bodies.slot[c.b];
            }
            if (mark != DEMI_ALL && marks[c.a] != mark && (c.b < 0 || marks[c.b] != mark)) continue;
            ok = demi_message_put(host, out, &c, sizeof c);
            head.contacts++;
        }
    if (ok) memcpy(out->bytes + start, &head, sizeof head);
    return ok;
}

/* Reserves memory for the histories and contacts of `come`, besides those filed already, and for
   `add` of demi_pairs_unpack. Moves all persistent contacts to the first work group. Returns 0 if
   memory ran out. */
static int demi_filed_reserve(dem_world *w, int32_t **add, const demi_message_head *come) {
    const int had = w->filed.count, rows = w->bodies.slot_count;
    int d, total = 0;
    demi_persistent *to;
    for (d = 0; d < DEMI_DOMAINS; d++) total += w->domains[d].persistent;
    if (!demi_carry_reserve(w, rows, had + come->pairs, come->stride) ||
        !DEMI_GROW(w, *add, (size_t)rows + 1) ||
        !DEMI_GROW(w, w->persistent_now, (size_t)(total + come->contacts)))
        return 0;
    if (!had) memset(w->filed.start, 0, ((size_t)rows + 2)*sizeof(int32_t));
    for (d = had ? w->filed.rows : rows; d < rows; d++) w->filed.start[d + 1] = w->filed.start[d];
    w->filed.rows = rows;
    w->filed.stride = come->stride;
    to = w->persistent_now;
    for (d = 0; d < DEMI_DOMAINS; d++) {
        demi_domain *o = &w->domains[d];
        if (o->persistent && d)
            memmove(to, demi_persistent_of(w, d), (size_t)o->persistent*sizeof *to);
        to += o->persistent;
        o->persistent = 0;
    }
    w->domains[0].persistent = total;
    w->domain_count = DEMI_MAX(w->domain_count, 1);        /* of a world without a list so far */
    for (d = 1; d <= DEMI_DOMAINS; d++) w->persistent_first[d] = total + come->contacts;
    return 1;
}
/* Adds `pairs` histories of a message to the filed ones, each at the end of its row. add: work
   array, the number of new entries of each row. */
static void demi_pairs_unpack(dem_world *w, int32_t *add, const char *from, int pairs) {
    const size_t per = (size_t)w->filed.stride*sizeof(dem_real), item = 3*sizeof(int32_t) + per;
    int32_t *start = w->filed.start, row, shift = pairs;
    int k;
    if (!pairs) return;
    memset(add, 0, ((size_t)w->filed.rows + 1)*sizeof(int32_t));
    for (k = 0; k < pairs; k++) {
        memcpy(&row, from + (size_t)k*item, sizeof row);
        add[row]++;
    }
    for (row = w->filed.rows - 1; row >= 0; row--) {          /* make gaps, from the last row on */
        const int32_t begin = start[row], n = start[row + 1] - begin;
        start[row + 1] += shift;
        shift -= add[row];
        if (!n || !shift) continue;
        memmove(w->filed.partner + begin + shift, w->filed.partner + begin,
                (size_t)n*sizeof(int32_t));
        memmove(w->filed.part + begin + shift, w->filed.part + begin, (size_t)n*sizeof(int32_t));
        memmove(w->filed.memory + (size_t)(begin + shift)*(size_t)w->filed.stride,
                w->filed.memory + (size_t)begin*(size_t)w->filed.stride, (size_t)n*per);
    }
    for (k = 0; k < pairs; k++) {
        int32_t to;
        demi_unpack(&from, &row, sizeof row);
        to = start[row + 1] - add[row]--;
        demi_unpack(&from, &w->filed.partner[to], sizeof(int32_t));
        demi_unpack(&from, &w->filed.part[to], sizeof(int32_t));
        demi_unpack(&from, w->filed.memory + (size_t)to*(size_t)w->filed.stride, per);
    }
    w->filed.count += pairs;
}
/* Files all histories and persistent contacts of a message. from: the end of its grains. */
static void demi_filed_unpack(dem_world *w, int32_t *add, const demi_message_head *h,
                            const char *from) {
    demi_domain *first = &w->domains[0];
    if (!h->pairs && !h->contacts) return;
    demi_pairs_unpack(w, add, from, h->pairs);
    from += (size_t)h->pairs*(3*sizeof(int32_t) + (size_t)h->stride*sizeof(dem_real));
    if (h->contacts)
        demi_unpack(&from, w->persistent_now + first->persistent,
                    (size_t)h->contacts*sizeof(demi_persistent));
    first->persistent += h->contacts;
}
