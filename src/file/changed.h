/* ---------------------------------------------------------------------------------------------
   >>changed
   dem_checkpoint_read_changed: a checkpoint read into a world whose desc, materials or pairs of
   materials differ where the caller allows it. The world takes on the values of the file while the
   file is read, so that all checks of a restart hold. Then it gets its own values back, as if they
   had been changed between two steps: lists are built again, contact histories are converted to the
   laws in force, and arrays that the world needs and the file lacks begin empty.
   Owns w->changes.
   --------------------------------------------------------------------------------------------- */

/* Fields of a dem_world_desc that may not differ: they decide what the numbers of a body mean. */
static const char demi_changes_never[] = " domain boundary planar thickness response body_reals "
    "law_memory_names groups ";
/* What a restart may change, and what it has changed. */
typedef struct demi_changes {
    const char *allowed;           /* words */
    const dem_world *own;          /* copy of the world struct before the restart: its descs and
                                      materials */
    int materials, paired;         /* 1: materials may differ; 1: pairs of materials may */
    demi_pair *pairs;              /* copy of its pairs; null if both are 0 */
    char said[512];
    int laws;                      /* 1: user-defined laws or their history differ */
    int ledger, growth;            /* 1: the file has an account of energy; its bodies grow */
} demi_changes;

/* True if the n characters at `word` are one of the words. */
static int demi_word_in(const char *words, const char *word, size_t n) {
    int k, length;
    const char *at;
    for (k = 0; (at = demi_name(words, k, &length)) != 0; k++)
        if ((size_t)length == n && !strncmp(at, word, n)) return 1;
    return 0;
}
/* True if a field of the world desc may differ at all. */
static int demi_may_change(const demi_field_row *r) {
    return !(r->how & DEMI_FREE) && r->type != 't' &&
        !demi_word_in(demi_changes_never, r->name, strlen(r->name));
}
/* Fails if a word is neither the name of a field that may differ nor "materials" nor "pairs". */
static dem_result demi_changes_check(dem_world *w, const char *allowed) {
    const demi_field_row *r;
    int k, n;
    const char *at;
    for (k = 0; (at = demi_name(allowed, k, &n)) != 0; k++) {
        if (demi_word_in("materials pairs", at, (size_t)n)) continue;
        for (r = demi_world_desc_rows; r->name && !(strlen(r->name) == (size_t)n &&
             !strncmp(r->name, at, (size_t)n) && demi_may_change(r)); r++) continue;
        if (r->name) continue;
        return demi_refuse(w, "dem_checkpoint_read_changed", "\"%.*s\" is not a field of "
                           "dem_world_desc that may differ, and not \"materials\" or \"pairs\"; "
                           "domain, boundary, planar, thickness, response and names must agree: "
                           "create the world with those of the file", DEMI_MIN(n, 60), at);
    }
    return DEM_OK;
}
/* Adds "name: A there, B here" to what has changed. */
static void demi_changes_say(demi_changes *c, const demi_field_row *r, const char *there,
                             const char *here, const char *of) {
    const size_t n = strlen(c->said), item = demi_row_item(r), count = r->size/item;
    char a[48], b[48];
    size_t k = 0;
    while (k + 1 < count && !memcmp(there + item*k, here + item*k, item)) k++;
    demi_row_print(r, there, k, 6, a, sizeof a);
    demi_row_print(r, here, k, 6, b, sizeof b);
    demi_words(c->said + n, sizeof c->said - n, "%s%s%s: %s there, %s here", n ? "; " : "", r->name,
               of, a, b);
}
/* Gives a field the value of the file. A function becomes one that is never called, or null. */
static void demi_change_put(const demi_field_row *r, void *item, const char *there) {
    void (*fn)(const dem_contact *, dem_real *, dem_contact_force *) = dem_law_hertz;
    int32_t set;
    if (r->type != 'p') { memcpy((char *)item + r->offset, there, r->size); return; }
    memcpy(&set, there, sizeof set);
    if (set) memcpy((char *)item + r->offset, &fn, sizeof fn);
    else memset((char *)item + r->offset, 0, sizeof fn);
}
/* True if the value of a pair, number i of the scene's pairs, is a mixture here and in the file, so
   that it follows from the materials, which are those of the file. */
static int demi_change_mixed(const dem_world *w, int i, const demi_field_row *r,
                             const char *there) {
    const int n = w->material_count, a = DEMI_MIN(i/n, i%n), b = DEMI_MAX(i/n, i%n);
    const dem_pair mix = demi_mix(&w->materials[a], &w->materials[b]);
    char value[DEMI_ROW_MOST];
    demi_row_value(r, &mix, value);
    return !w->pairs[a*DEMI_MATERIALS + b].own && !memcmp(value, there, r->size);
}
/* Compares the descs, materials and pairs in the file with those of the world. Where they differ
   and may, the world takes the value of the file. What may not differ stays, and reading fails. */
static void demi_changes_take(dem_world *w, demi_changes *c, demi_stream *s) {
    int32_t counts[DEMI_PARTS];
    char here[DEMI_ROW_MOST], there[DEMI_ROW_MOST], of[48];
    const demi_field_row *r;
    int part, i;
    demi_scene_counts(w, counts);
    for (part = 0; part <= DEMI_PART_PAIRS; part++)
        for (i = 0; i < counts[part]; i++)
            for (r = demi_scene_parts[part].rows; r->name; r++) {
                const int n = w->material_count;
                const int may = part == 0 ? demi_may_change(r) &&
                    demi_word_in(c->allowed, r->name, strlen(r->name))
                    : part == 1 ? c->materials && strcmp(r->name, "density") : c->paired;
                void *item = part == 0 ? (void *)&w->asked : part == 1 ? (void *)&w->materials[i]
                    : (void *)&w->pairs[i/n*DEMI_MATERIALS + i%n].given;
                if (r->how & DEMI_FREE) continue;
                demi_row_value(r, item, here);
                demi_visit(s, there, r->size);
                if (s->cut || !memcmp(here, there, r->size)) continue;
                if (!may && part == 2 && c->materials && demi_change_mixed(w, i, r, there))
                    demi_change_put(r, item, there);
                if (!may) continue;
                *of = 0;
                if (part == 1) demi_words(of, sizeof of, " of material %d", i + 1);
                if (part == 2)
                    demi_words(of, sizeof of, " of materials %d and %d", i/n + 1, i%n + 1);
                if (part < 2 || i/n <= i%n) demi_changes_say(c, r, there, here, of);
                demi_change_put(r, item, there);
                if (part) continue;
                demi_change_put(r, &w->desc, there);
                c->laws |= !strncmp(r->name, "law", 3) && (r->type == 'p' || r->type == 'i');
            }
}
/* Gives the world its own values back. */
static void demi_changes_back(dem_world *w, const demi_changes *c) {
    const demi_field_row *r;
    for (r = demi_world_desc_rows; r->name; r++) {
        const size_t size = r->type == 'p' && !(r->how & DEMI_FREE) ? sizeof(void (*)(void))
            : r->size;
        if (!demi_may_change(r) || !demi_word_in(c->allowed, r->name, strlen(r->name))) continue;
        memcpy((char *)&w->desc + r->offset, (const char *)&c->own->desc + r->offset, size);
        memcpy((char *)&w->asked + r->offset, (const char *)&c->own->asked + r->offset, size);
    }
    w->desc.integrator = c->own->desc.integrator;  /* of impulses: chosen at creation */
    if (c->materials) memcpy(w->materials, c->own->materials, sizeof w->materials);
    if (c->pairs)
        memcpy(w->pairs, c->pairs, (size_t)DEMI_MATERIALS*DEMI_MATERIALS*sizeof *w->pairs);
}
/* Allocates the arrays of bodies that the world needs beside those of the file, zeros. Returns 0 if
   memory ran out. */
static int demi_changes_arrays(dem_world *w) {
    const int backward = demi_integrator_of(w)->backward;
    const int booked = w->desc.ledger && demi_integrator_of(w)->predicts;
    const size_t room = (size_t)w->bodies.capacity;
    const int sets = (backward && !w->bodies.backward) << DEMI_BACK |
        (backward && !w->bodies.backward && w->bodies.orienting) << DEMI_BACK_TURNED |
        (booked && !w->bodies.booked) << DEMI_BOOKED;
    int k;
    if (w->asked.orientations && !demi_orient_begin(w)) return 0;
    if (sets && !demi_bodies_room(w, sets, 0, room)) return 0;
    for (k = 0; k < DEMI_BODY_ARRAYS && room; k++) {
        const demi_body_array *a = &demi_body_arrays[k];
        if (sets >> a->who & 1) memset(demi_data(w, a), 0, room*demi_item(w, a));
    }
    w->bodies.backward = backward;
    w->bodies.booked = booked;
    return 1;
}
/* Gives the twin, which has read the file with the values of the file, the world's own values. */
static dem_result demi_changes_apply(dem_world *w, void *how) {
    const demi_changes *c = (const demi_changes *)how;
    int d, i, j;
    double kinetic, rotational;
    memcpy(w->changes, c->said, sizeof w->changes);
    if (!demi_name(c->allowed, 0, &d)) return DEM_OK;
    if (!demi_list_drop(w)) return DEM_ERROR_MEMORY;
    demi_changes_back(w, c);
    if (!demi_changes_arrays(w)) return DEM_ERROR_MEMORY;
    for (i = 0; i < w->material_count; i++)     /* damping depends on desc.tension */
        for (j = i; j < w->material_count; j++) {
            const dem_pair pair = w->pairs[i*DEMI_MATERIALS + j].given;
            demi_pair_put(w, i, j, &pair);
        }
    if (c->laws) demi_filed_forget(w);          /* they mean something else */
    for (d = 0; d < w->domain_count && c->laws; d++) w->domains[d].persistent = 0;
    if (c->pairs) demi_surfaces_outdated(w);
    if (!w->desc.ledger) demi_events_clear(w);  /* without an account nothing is recorded */
    if (w->desc.ledger && !c->ledger) {            /* its account begins now */
        demi_kinetic(w, &kinetic, &rotational);
        memset(w->booked.energy, 0, sizeof w->booked.energy);
        w->booked.inserted = kinetic + rotational;
        w->booked.removed = w->booked.throughput = 0;
    }
    if (!c->growth) w->clock.grown = w->clock.time;     /* growth begins now */
    demi_lll_outdated(w);
    demi_pairs_changed(w);
    demi_scene_changed(w);
    /* now laws and histories agree, also in a checkpoint that is written before the next step */
    return demi_effects_take(w) ? DEM_OK : DEM_ERROR_MEMORY;
}
DEM_API dem_result dem_checkpoint_read_changed(dem_world *w, const char *path,
                                               const char *allowed) {
    const size_t pairs = (size_t)DEMI_MATERIALS*DEMI_MATERIALS*sizeof(demi_pair);
    if (demi_null(w, __func__, allowed, "allowed")) return DEM_ERROR_ARGUMENT;
    const dem_world own = *w;
    demi_checkpoint_head head;
    demi_changes c;
    demi_stream s;
    char *bytes = 0;
    size_t size = 0;
    dem_result result = demi_changes_check(w, allowed);
    if (result == DEM_OK) result = demi_load(w, __func__, path, &bytes, &size);
    if (result == DEM_OK) result = demi_checkpoint_check(w, path, bytes, size, &head);
    memset(&c, 0, sizeof c);
    memset(&s, 0, sizeof s);
    c.allowed = allowed;
    c.own = &own;
    c.materials = demi_word_in(allowed, "materials", 9);
    c.paired = demi_word_in(allowed, "pairs", 5);
    if (result == DEM_OK && (c.materials || c.paired)) {
        c.pairs = (demi_pair *)demi_alloc(w, 1, pairs);
        if (c.pairs) memcpy(c.pairs, w->pairs, pairs);
        else result = demi_no_memory(w, __func__);
    }
    if (result == DEM_OK) {
        s.from = bytes + sizeof head;
        s.left = (size_t)head.body_size;
        demi_changes_take(w, &c, &s);
        w->bodies.backward = demi_integrator_of(w)->backward;
        w->bodies.booked = w->desc.ledger && demi_integrator_of(w)->predicts;
        c.ledger = w->desc.ledger;
        c.growth = w->desc.growth != 0;
        result = demi_checkpoint_parse(w, path, bytes, size, demi_changes_apply, &c);
        if (result != DEM_OK) {
            demi_changes_back(w, &c);
            w->bodies.backward = demi_integrator_of(w)->backward;
            w->bodies.booked = w->desc.ledger && demi_integrator_of(w)->predicts;
        }
        if (result == DEM_ERROR_MEMORY) demi_no_memory(w, __func__);
    }
    demi_free(w, c.pairs);
    demi_free(w, bytes);
    return result;
}
DEM_API const char *dem_checkpoint_changes_get(const dem_world *w) { return w ? w->changes : ""; }
