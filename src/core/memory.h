/* ---------------------------------------------------------------------------------------------
   >>memory
   Memory and errors: the table of the arrays that hold a value for each body, the user's names, the
   checks at the start of every public function, error messages, allocation and growing arrays. All
   memory of a world is allocated and freed here.
   --------------------------------------------------------------------------------------------- */
/* Returns word k of a list of names, such as body_reals, and its length; null if there is none. */
static const char *demi_name(const char *names, int k, int *length) {
    const char *at = names ? names : "";
    for (;; k--) {
        at += strspn(at, " ");
        *length = (int)strcspn(at, " ");
        if (!*length) return 0;
        if (!k) return at;
        at += *length;
    }
}
/* Returns the number of names; -1 if there are more than `most` or one is not a valid name. */
static int demi_names(const char *names, int most) {
    int count = 0, length, i;
    const char *at;
    while ((at = demi_name(names, count, &length)) != 0) {
        for (i = 0; i < length; i++)
            if (!strchr("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_", at[i]))
                return -1;
        if (length > 23 || ++count > most) return -1;
    }
    return count;
}
/* Copies the names, separated by single spaces. Returns their number. */
static int demi_names_copy(const char *names, char *out) {
    const char *name;
    int k, n;
    *out = 0;
    for (k = 0; (name = demi_name(names, k, &n)) != 0; k++)
        sprintf(out + strlen(out), "%s%.*s", k ? " " : "", n, name);
    return k;
}
/* Points the descs at the names that the world itself stores; needed after a world is copied. */
static void demi_names_point(dem_world *w) {
    w->desc.body_reals = w->asked.body_reals = w->real_names[0] ? w->real_names : 0;
    w->desc.groups = w->asked.groups = w->group_names[0] ? w->group_names : 0;
    w->desc.law_memory_names = w->asked.law_memory_names = w->memory_names[0] ? w->memory_names : 0;
}
static void demi_names_own(dem_world *w, const dem_world_desc *desc) {
    w->bodies.real_count = demi_names_copy(desc->body_reals, w->real_names);
    w->bodies.group_count = demi_names_copy(desc->groups, w->group_names);
    demi_names_copy(desc->law_memory_names, w->memory_names);
    demi_names_point(w);
}
/* --- arrays with a value for each body. Loops over these rows (>>bodies) allocate, add, remove,
       sort, check, save and send them to other slabs.

       >>add-array: a field in demi_bodies above and a row here.

       who: when the array exists
         DEMI_EVERY        always
         DEMI_BACK         if the positions of the previous step are needed (bodies.backward)
         DEMI_TURNED       if bodies have orientations
         DEMI_BACK_TURNED  if both of these hold
         DEMI_COUNTED      if bodies have user-defined numbers; one item for each number
         DEMI_ZONED        if there are outlets that only count
         DEMI_GROUPED      if desc.groups names groups
         DEMI_AGED         if an outlet measures residence times
         DEMI_AVERAGED     if a field averages bodies
         DEMI_BOOKED       with a ledger and an integrator that predicts velocities
         DEMI_SLOTS        always, with one item for each slot instead of each body
       what: how it is used
         DEMI_KEPT         part of the state; 0 in a new body unless set
         DEMI_REALS        the same, and reals that must be finite
         DEMI_PLACES       the same; x, y, z are a position, which periodic wrapping shifts
         0                 scratch memory --- */
enum { DEMI_EVERY, DEMI_BACK, DEMI_TURNED, DEMI_BACK_TURNED, DEMI_COUNTED, DEMI_ZONED, DEMI_AGED,
       DEMI_AVERAGED, DEMI_BOOKED, DEMI_GROUPED, DEMI_SLOTS };
enum { DEMI_MEANS = 19 };          /* doubles of a body's averages: see demi_means_add */
enum { DEMI_KEPT = 1, DEMI_REALS = 3, DEMI_PLACES = 7 };
typedef struct demi_body_array {
    size_t field, item;            /* offset of its pointer in demi_bodies; bytes per body (for
                                      DEMI_COUNTED: per number, see demi_item) */
    int who, what;
} demi_body_array;
#define DEMI_ARRAY(field, count, who, what) \
    {offsetof(demi_bodies, field), (count)*sizeof *((demi_bodies *)0)->field, who, what}
static const demi_body_array demi_body_arrays[] = {
    DEMI_ARRAY(slot,            1, DEMI_EVERY,  DEMI_KEPT),     /* must be first: demi_body_take */
    DEMI_ARRAY(material,        1, DEMI_EVERY,  DEMI_KEPT),
    DEMI_ARRAY(pos,             4, DEMI_EVERY,  DEMI_PLACES),
    DEMI_ARRAY(vel,             4, DEMI_EVERY,  DEMI_REALS),
    DEMI_ARRAY(spin,            4, DEMI_EVERY,  DEMI_REALS),
    DEMI_ARRAY(half_vel,        4, DEMI_EVERY,  DEMI_REALS),
    DEMI_ARRAY(half_spin,       4, DEMI_EVERY,  DEMI_REALS),
    DEMI_ARRAY(force,           4, DEMI_EVERY,  DEMI_REALS),
    DEMI_ARRAY(torque,          4, DEMI_EVERY,  DEMI_REALS),
    DEMI_ARRAY(mass,            1, DEMI_EVERY,  DEMI_REALS),
    DEMI_ARRAY(inv_mass,        1, DEMI_EVERY,  DEMI_REALS),
    DEMI_ARRAY(inv_inertia,     1, DEMI_EVERY,  DEMI_REALS),
    DEMI_ARRAY(last_pos,        4, DEMI_BACK,   DEMI_PLACES),
    DEMI_ARRAY(went,            1, DEMI_BACK,   DEMI_KEPT),
    DEMI_ARRAY(late,            4, DEMI_BOOKED, DEMI_REALS),
    DEMI_ARRAY(orient,          4, DEMI_TURNED, DEMI_REALS),
    DEMI_ARRAY(last_orient,     4, DEMI_BACK_TURNED, DEMI_REALS),
    DEMI_ARRAY(angular,         4, DEMI_TURNED, DEMI_REALS),
    DEMI_ARRAY(moment,          4, DEMI_TURNED, DEMI_REALS),
    DEMI_ARRAY(shape,           1, DEMI_TURNED, DEMI_KEPT),
    DEMI_ARRAY(reals,           1, DEMI_COUNTED, DEMI_REALS),
    DEMI_ARRAY(rates,           1, DEMI_COUNTED, DEMI_REALS),
    DEMI_ARRAY(zones,           1, DEMI_ZONED,  DEMI_KEPT),
    DEMI_ARRAY(groups,          1, DEMI_GROUPED, DEMI_KEPT),
    DEMI_ARRAY(born,            1, DEMI_AGED,   DEMI_KEPT),
    DEMI_ARRAY(means,  DEMI_MEANS, DEMI_AVERAGED, DEMI_KEPT),
    DEMI_ARRAY(scratch,         4, DEMI_EVERY,  0),
    DEMI_ARRAY(order,           1, DEMI_EVERY,  0),
    DEMI_ARRAY(cell_of,         1, DEMI_EVERY,  0),
    DEMI_ARRAY(slot_index,      1, DEMI_SLOTS,  DEMI_KEPT),
    DEMI_ARRAY(slot_generation, 1, DEMI_SLOTS,  DEMI_KEPT)};
enum { DEMI_BODY_ARRAYS = (int)(sizeof demi_body_arrays/sizeof *demi_body_arrays) };

/* True if the call, whose name has n characters, changes the setup of a scene: a run without it
   would be a different simulation. Calls that remove, read or write do not count. */
static int demi_builds(const char *call, size_t n) {
    static const char *const ends[] = {"_add", "_fill", "_pack", "dem_pair_set", "dem_material_set",
                                       "dem_wall_motion_set"};
    size_t k, l;
    for (k = 0; k < sizeof ends/sizeof *ends; k++) {
        l = strlen(ends[k]);
        if (n >= l && !memcmp(call + n - l, ends[k], l)) return 1;
    }
    return 0;
}
/* Returns the index of the call among the failed ones, or -1. */
static int demi_refused_find(const dem_world *w, const char *call, size_t n) {
    int k;
    for (k = 0; k < w->refused; k++)
        if (strlen(w->refused_calls[k]) == n && !memcmp(w->refused_calls[k], call, n)) return k;
    return -1;
}

/* Remembers a failed call that builds the scene, whose name is the first n characters of w->error,
   until the message is read or the call succeeds. */
static void demi_refused_note(dem_world *w, size_t n) {
    const size_t calls = sizeof w->refused_calls/sizeof *w->refused_calls;
    if (n >= sizeof *w->refused_calls || !demi_builds(w->error, n)) return;
    if (!w->refused) memcpy(w->refusal, w->error, sizeof w->refusal);
    if (demi_refused_find(w, w->error, n) < 0 && (size_t)w->refused < calls) {
        memcpy(w->refused_calls[w->refused], w->error, n);
        w->refused_calls[w->refused++][n] = 0;
    }
}
/* Stores the error message of a failed call. The message begins with `call`, the name of the call;
   if that is null, `format` contains the name. */
static void demi_tell(dem_world *w, const char *call, const char *format,
                      va_list args) DEMI_FORMAT(3, 0);
static void demi_tell(dem_world *w, const char *call, const char *format, va_list args) {
#if DEMI_OPENMP
    #pragma omp critical(demi_fail)             /* laws may fail on several threads at once */
#endif
    {
        const int n = call ? demi_words(w->error, sizeof w->error, "%s: ", call) : 0;
        demi_words_of(w->error + n, sizeof w->error - (size_t)n, format, args);
        demi_refused_note(w, strcspn(w->error, ":"));
    }
}
/* Stores an error message and returns `result`. */
static dem_result demi_fail(dem_world *w, dem_result result, const char *format,
                            ...) DEMI_FORMAT(3, 4);
static dem_result demi_fail(dem_world *w, dem_result result, const char *format, ...) {
    va_list args;
    va_start(args, format);
    demi_tell(w, 0, format, args);
    va_end(args);
    return result;
}
/* Stores the message "call: format" about an argument, or a state of the world, that the call does
   not accept. The world may be const, because only its message changes. Returns
   DEM_ERROR_ARGUMENT. */
static dem_result demi_refuse(const dem_world *w, const char *call, const char *format,
                              ...) DEMI_FORMAT(3, 4);
static dem_result demi_refuse(const dem_world *w, const char *call, const char *format, ...) {
    va_list args;
    va_start(args, format);
    demi_tell((dem_world *)w, call, format, args);
    va_end(args);
    return DEM_ERROR_ARGUMENT;
}
/* Call this when a call that builds the scene has succeeded: an earlier failure of the same call no
   longer prevents a run. */
static void demi_built(dem_world *w, const char *call) {
    const size_t n = strlen(call);
    const int k = demi_refused_find(w, call, n);
    if (k < 0) return;
    memmove(w->refused_calls[k], w->refused_calls[k + 1],
            (size_t)(--w->refused - k)*sizeof *w->refused_calls);
    if (!w->refused || strncmp(w->refusal, call, n) || w->refusal[n] != ':') return;
    demi_words(w->refusal, sizeof w->refusal, "%s: failed as well", w->refused_calls[0]);
}
/* Fails before a run if a call that builds the scene failed and its message has not been read.
   Otherwise an incomplete scene would run and return DEM_OK. */
static dem_result demi_unbuilt(dem_world *w, const char *call) {
    char why[sizeof w->refusal];
    if (!w->refused) return DEM_OK;
    memcpy(why, w->refusal, sizeof why);
    return demi_refuse(w, call, "did not start, because an earlier call failed and its message has "
                       "not been read: \"%.320s\"; correct that call, or read dem_world_error_get "
                       "and continue without it", why);
}
/* The first line of every public function is one of the next three. They return 1 if the world or
   `pointer` is null, and store an error message if there is a world to hold it. The first is for
   functions that only read: any thread and any user-defined function may call them. */
static int demi_null_look(const dem_world *w, const char *call, const void *pointer,
                          const char *name) {
    if (w && pointer) return 0;
    if (w) demi_refuse(w, call, "%s is null; give its address", name);
    return 1;
}
/* Fails because a user-defined function made a call that it may not make. Returns 1. */
static int demi_barred(dem_world *w, const char *call) {
    demi_refuse(w, call, "called from a function that %s calls (law, field, motion, region, "
                "progress or the like), which may only read the world; make this call after %s has "
                "returned, or between two steps in an output of kind DEM_OUTPUT_CALL",
                w->look.calling.who, w->look.calling.who);
    return 1;
}
/* For functions that allocate memory of the world but do not change its state, for example those
   that read or write files. They fail within a step. */
static int demi_null_write(dem_world *w, const char *call, const void *pointer, const char *name) {
    return demi_null_look(w, call, pointer, name) ||
        (w->look.calling.who && w->look.calling.within && demi_barred(w, call));
}
/* For all others. They fail in every user-defined function except those of outputs. */
static int demi_null(dem_world *w, const char *call, const void *pointer, const char *name) {
    return demi_null_look(w, call, pointer, name) || (w->look.calling.who && demi_barred(w, call));
}
static const dem_material demi_no_material = {0};
static const dem_shape demi_no_shape = {0};
static const dem_body demi_no_body = {0, 0};
static const dem_wall demi_no_wall = {0};
static const dem_field demi_no_field = {0};
static const dem_feed demi_no_feed = {0};
static const dem_outlet demi_no_outlet = {0};
static const dem_joint demi_no_joint = {0};

static dem_result demi_no_memory(dem_world *w, const char *call) {
    return demi_fail(w, DEM_ERROR_MEMORY, "%s: out of memory with %.1f MB held; use fewer bodies "
                     "or a smaller skin; nothing was lost", call, (double)w->bytes/1e6);
}

/* Allocate and free by the user's allocator, which may not change the world; w is null while there
   is none. */
static void *demi_raw_alloc(dem_world *w, const dem_allocator *a, size_t size) {
    void *p;
    if (!a->alloc_fn) return malloc(size);
    if (!w) return DEMI_USER_WITHIN(a->alloc_fn(size, a->user));
    DEMI_USER(w, "the allocation of memory", 1, p = a->alloc_fn(size, a->user))
    return p;
}
static void demi_raw_free(dem_world *w, const dem_allocator *a, void *p, size_t size) {
    if (!p || !a->free_fn) free(p);
    else if (!w) DEMI_USER_WITHIN(a->free_fn(p, size, a->user));
    else DEMI_USER(w, "the release of memory", 1, a->free_fn(p, size, a->user))
}
/* Header in front of every allocation. The data after it begin on a cache line, so that no row of
   four reals crosses one. The header stores the size, so that freeing and growing need no size
   argument. */
typedef struct demi_block {
    struct demi_block *before, *after;         /* neighbours in its list */
    size_t bytes;                              /* size of the data */
    int in, chain;                             /* offset of the data in the allocator's block,
                                                  bytes; its list: DEMI_SCENE, ... */
} demi_block;
enum { DEMI_LINE = 64 };
static demi_block *demi_block_of(void *data) { return (demi_block *)data - 1; }
/* Capacity of an allocation in items of `item` bytes; 0 for null. */
static size_t demi_room(const void *data, size_t item) {
    return data ? ((const demi_block *)data - 1)->bytes/item : 0;
}
/* Allocates `count` items of `size` bytes, set to 0, and links them into a list of the world. With
   DEMI_LOOSE they are in no list and the caller must free them. Returns null if memory runs out,
   the product overflows or is 0. */
static void *demi_hold(dem_world *w, int chain, size_t count, size_t size) {
    const size_t bytes = count*size;
    unsigned char *p;
    demi_block *block;
    int in;
    if ((size && count > (size_t)-1/2/size) || !bytes) return 0;
    p = (unsigned char *)demi_raw_alloc(w, &w->desc.allocator, bytes + 2*DEMI_LINE);
    if (!p) return 0;
    in = 2*DEMI_LINE - (int)((uintptr_t)p%DEMI_LINE);
    memset(p + in, 0, bytes);
    block = (demi_block *)(void *)(p + in) - 1;
    block->before = 0;
    block->after = chain ? w->chains[chain] : 0;
    block->bytes = bytes;
    block->in = in;
    block->chain = chain;
    if (block->after) block->after->before = block;
    if (chain) w->chains[chain] = block;
    w->bytes += bytes + 2*DEMI_LINE;
    return p + in;
}
static void *demi_alloc(dem_world *w, size_t count, size_t size) {
    return demi_hold(w, DEMI_LOOSE, count, size);
}
static void demi_free(dem_world *w, void *data) {
    demi_block *block;
    if (!data) return;
    block = demi_block_of(data);
    if (block->after) block->after->before = block->before;
    if (block->before) block->before->after = block->after;
    else if (block->chain) w->chains[block->chain] = block->after;
    w->bytes -= block->bytes + 2*DEMI_LINE;
    demi_raw_free(w, &w->desc.allocator, (unsigned char *)data - block->in,
                  block->bytes + 2*DEMI_LINE);
}
/* True if the allocation is in this list of the world. A copy of a world refers to allocations of
   the original, which it must not free. */
static int demi_owns(const dem_world *w, int chain, const void *data) {
    const demi_block *block = w->chains[chain];
    while (block && (const void *)(block + 1) != data) block = block->after;
    return block != 0;
}
/* Frees every allocation of a list. */
static void demi_free_chain(dem_world *w, int chain) {
    while (w->chains[chain]) demi_free(w, w->chains[chain] + 1);
}
/* Grows an array of the world to hold at least `count` items and keeps its contents; it never
   shrinks. An array grown to 0 items is not null, because null + 0 is undefined in C. Returns 0 if
   memory runs out; the array is then unchanged. */
#define DEMI_GROW(w, array, count) demi_grow(w, DEMI_RUN, &(array), sizeof *(array), count)
static int demi_grow(dem_world *w, int chain, void *array, size_t item, size_t count) {
    void *old, *fresh;
    size_t room;
    memcpy(&old, array, sizeof old);            /* any type of pointer */
    room = demi_room(old, item);
    if (old && count <= room) return 1;
    /* exactly `count` for a large request, else by a quarter */
    fresh = demi_hold(w, chain, DEMI_MAX(count, room + room/4 + 16), item);
    if (!fresh) return 0;
    if (old) memcpy(fresh, old, room*item);
    memcpy(array, &fresh, sizeof fresh);
    demi_free(w, old);
    return 1;
}
/* Grows an array for `count` items, as DEMI_GROW, and copies those of another one to it. Returns 0
   if memory ran out. */
#define DEMI_COPY(w, array, from, count) demi_copy(w, &(array), from, sizeof *(array), count)
static int demi_copy(dem_world *w, void *array, const void *from, size_t item, int count) {
    void *to;
    if (!demi_grow(w, DEMI_RUN, array, item, (size_t)count)) return 0;
    memcpy(&to, array, sizeof to);
    if (count) memcpy(to, from, (size_t)count*item);
    return 1;
}
