/* ---------------------------------------------------------------------------------------------
   >>slabs
   Spatial decomposition along one axis, after [ALK07] 3.5. Each slab is a world of its own: the
   walls of the scene, its own grains, and copies of those grains of its lower neighbour that may
   touch them: its ghosts. Slots are those of the whole scene, so that contact memory, filed by
   slot, finds its pair in any slab. One step:
       move     own grains; ghosts stand still
       decide   a new list? a new near list? one maximum over all slabs
       send up  state of the grains that are ghosts in the upper neighbour
       respond  own - own, own - ghost, own - wall; ghost - ghost belongs to the owner
       return   forces on ghosts go down to their owners, who add them
   The step itself is that of a world on its own (>>step): slabs are the parts of a team (>>team),
   and here is what the parts exchange and agree on.
   [ALK07] sends copies down; up is the mirror image. At a rebuild grains that crossed a border
   migrate, with a copy of every entry of contact memory that names them: so whichever slab computes
   a pair next has its memory. (It is the upper of the pair's two homes; the pair was computed where
   one of them was, and that one either stays or passes through.) Then ghosts are chosen anew.
   A slab is never thinner than two grains and the skin, so that only neighbours touch.

   Work is done in phases: one function per slab, all slabs of this process in demi_parallel; a
   phase writes only to its own slab and reads its neighbours' outboxes, which rest meanwhile.
   Between phases outboxes that lead to other processes are exchanged. What is reduced over
   processes is maxima, and sums of whole numbers, which are exact in any order: so bits hang on the
   number of slabs alone, not on threads or processes.

   All slabs but the first of a process see walls that never move by themselves: the poses are
   copied, so that a motion of the user's own is called as often as ever.
   --------------------------------------------------------------------------------------------- */
enum { DEMI_SLABS = 1024, DEMI_SLAB_BINS = 32, DEMI_UP = 1, DEMI_DOWN = 2, DEMI_ALL = 0,
       DEMI_GHOST = 1, DEMI_GOES_DOWN = 2, DEMI_GOES_UP = 3, DEMI_GHOST_ABOVE = 4 };

/* A message: bytes that grow. */
typedef struct demi_message { char *bytes; size_t size; } demi_message;

typedef struct demi_slab {
    dem_world *world;
    int index;                     /* among all */
    dem_result result;             /* of the last phases; looked at by demi_slabs_agree */
    demi_message out[2];            /* to the lower, to the upper neighbour */
    demi_message in[2];             /* from them, when they are in another process */
    int32_t *lent, *ghost;         /* indices of own grains that are ghosts above; of ghosts here */
    dem_real *ghost_inv;           /* x 2: 1/mass, 1/inertia of ghosts */
    int32_t *add;                  /* see demi_pairs_unpack */
    int lent_count, ghost_count, leavers;
    uint64_t bytes, migrated;
    double work, seconds;
    demi_crowd crowd;              /* who is near the region of a feed */
} demi_slab;

/* The head is a world without grains of its own: it holds what the slabs have in common (time,
   step, skin, errors), and lends itself to functions that ask a world for totals. It has the feeds,
   too: every process draws for all slabs, and so all draw the same. It comes first, so that a task
   finds its slabs. */
struct dem_slabs {
    dem_world head;
    dem_slabs_desc desc;
    int axis, count, first, local, ring, broken;
    double period, cut;            /* m: along the axis; thinnest slab there may be */
    double *borders;               /* count + 1 */
    double *values;                /* for reductions: value_room */
    size_t value_room;
    demi_slab *slabs;              /* local */
    demi_domain total;             /* the head's only domain */
    demi_message mine, all;         /* for dem_slabs_collect */
    uint32_t *known;               /* by slot: generation of the body dealt or fed, 0: none */
    int dealt, told, slots;        /* how many slots: dealt, known to the world, there are */
    uint64_t border_moves;
    void (*phase)(struct dem_slabs *s, demi_slab *b);
    demi_team team;
    dem_result (*task)(dem_world *member);      /* of the phase that is running */
    const demi_record *record;
};

/* --- messages --- */

/* Appends bytes. 0 when memory ran out; what was there stays. */
static int demi_message_put(dem_world *w, demi_message *p, const void *data, size_t size) {
    if (!DEMI_GROW(w, p->bytes, p->size + size)) return 0;
    if (size) memcpy(p->bytes + p->size, data, size);
    p->size += size;
    return 1;
}
static void demi_unpack(const char **from, void *to, size_t size) {
    if (!size) return;                          /* of a message that is not there, too */
    memcpy(to, *from, size);
    *from += size;
}

/* --- a grain in a message: all it keeps, the rows of demi_body_arrays one after the other, its
       slot first --- */

/* Body i, its places moved by `shift` along axis. 0 when memory ran out. */
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
/* Body i becomes the one that arrived. */
static void demi_grain_unpack(dem_world *w, int i, const char **from) {
    int k;
    for (k = 0; k < DEMI_BODY_ARRAYS; k++) {
        const demi_body_array *a = &demi_body_arrays[k];
        if (demi_keeps(w, a))
            demi_unpack(from, demi_datum(w, a, i), demi_item(w, a));
    }
}
static uint32_t demi_grain_slot(const char *from) {
    uint32_t slot;
    memcpy(&slot, from, sizeof slot);
    return slot;
}
/* Room has been seen to. Answers its index. */
static int demi_grain_append(dem_world *w, const char **from) {
    const int i = w->bodies.count++;
    demi_grain_unpack(w, i, from);
    w->bodies.slot_index[w->bodies.slot[i]] = i;
    if (demi_shape_of(w, i)) w->bodies.shaped++;
    w->lll_valid = 0;
    return i;
}
/* Takes a grain out of a slab without its having left the scene. */
static void demi_grain_forget(dem_world *w, int i) {
    const int slot = (int)w->bodies.slot[i], pending = w->bodies.slot_pending;
    const double removed = w->booked.removed;
    demi_body_take_out(w, i);
    w->bodies.slot_pending = pending;
    w->bodies.slot_index[slot] = -1;
    w->bodies.slot_generation[slot]--;
    w->booked.removed = removed;
    w->bodies.ghost[slot] = 0;
}

/* Grains whose mark is `mark`; with them, when asked, the filed memory of pairs that name one of
   them, their contacts that are kept (all there are, for mark DEMI_ALL).
   shift: added along axis. Memory must be filed: after demi_list_drop or demi_carry_collect. */
typedef struct demi_message_head {
    int32_t grains, pairs, contacts, stride;
} demi_message_head;
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
                 demi_message_put(host, out, w->filed.memory + (size_t)k*(size_t)stride,
                                 (size_t)stride*sizeof(dem_real));
            head.pairs++;
        }
    for (d = 0; memory && d < DEMI_DOMAINS && ok; d++)
        for (k = 0; k < w->domains[d].kept && ok; k++) {
            demi_kept c = demi_kept_of(w, d)[k];
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

/* Room for what is to arrive by these heads, beside what is filed already; `add` for
   demi_pairs_unpack. Contacts that are there move to the first domain. 0 when memory ran out. */
static int demi_filed_reserve(dem_world *w, int32_t **add, const demi_message_head *come) {
    const int had = w->filed.count, rows = w->bodies.slot_count;
    int d, total = 0;
    demi_kept *to;
    for (d = 0; d < DEMI_DOMAINS; d++) total += w->domains[d].kept;
    if (!demi_carry_reserve(w, rows, had + come->pairs, come->stride) ||
        !DEMI_GROW(w, *add, (size_t)rows + 1) ||
        !DEMI_GROW(w, w->kept_now, (size_t)(total + come->contacts)))
        return 0;
    if (!had) memset(w->filed.start, 0, ((size_t)rows + 2)*sizeof(int32_t));
    for (d = had ? w->filed.rows : rows; d < rows; d++) w->filed.start[d + 1] = w->filed.start[d];
    w->filed.rows = rows;
    w->filed.stride = come->stride;
    to = w->kept_now;
    for (d = 0; d < DEMI_DOMAINS; d++) {
        demi_domain *o = &w->domains[d];
        if (o->kept && d)
            memmove(to, demi_kept_of(w, d),
                    (size_t)o->kept*sizeof *to);
        to += o->kept;
        o->kept = 0;
    }
    w->domains[0].kept = total;
    for (d = 1; d <= DEMI_DOMAINS; d++) w->kept_first[d] = total + come->contacts;
    return 1;
}
/* Files pairs that arrived behind those already in their rows. */
static void demi_pairs_unpack(dem_world *w, int32_t *add, const char *from, int pairs) {
    const size_t per = (size_t)w->filed.stride*sizeof(dem_real), item = 2*sizeof(int32_t) + per;
    int32_t *start = w->filed.start, row, shift = pairs;
    int k;
    if (!pairs) return;
    memset(add, 0, ((size_t)w->filed.rows + 1)*sizeof(int32_t));
    for (k = 0; k < pairs; k++) {
        memcpy(&row, from + (size_t)k*item, sizeof row);
        add[row]++;
    }
    for (row = w->filed.rows - 1; row >= 0; row--) {          /* make gaps, from the far end on */
        const int32_t begin = start[row], n = start[row + 1] - begin;
        start[row + 1] += shift;
        shift -= add[row];
        if (!n || !shift) continue;
        memmove(w->filed.partner + begin + shift, w->filed.partner + begin,
                (size_t)n*sizeof(int32_t));
        memmove(w->filed.memory + (size_t)(begin + shift)*(size_t)w->filed.stride,
                w->filed.memory + (size_t)begin*(size_t)w->filed.stride, (size_t)n*per);
    }
    for (k = 0; k < pairs; k++) {
        int32_t to;
        demi_unpack(&from, &row, sizeof row);
        to = start[row + 1] - add[row]--;
        demi_unpack(&from, &w->filed.partner[to], sizeof(int32_t));
        demi_unpack(&from, w->filed.memory + (size_t)to*(size_t)w->filed.stride, per);
    }
    w->filed.count += pairs;
}
/* What a message has besides grains, which end at `from`: files all of it. */
static void demi_filed_unpack(dem_world *w, int32_t *add, const demi_message_head *h,
                            const char *from) {
    demi_domain *first = &w->domains[0];
    if (!h->pairs && !h->contacts) return;
    demi_pairs_unpack(w, add, from, h->pairs);
    from += (size_t)h->pairs*(2*sizeof(int32_t) + (size_t)h->stride*sizeof(dem_real));
    if (h->contacts)
        demi_unpack(&from, w->kept_now + first->kept, (size_t)h->contacts*sizeof(demi_kept));
    first->kept += h->contacts;
}
