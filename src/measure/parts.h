/* ---------------------------------------------------------------------------------------------
   >>parts
   The scene as rows of fields, part by part: what a checkpoint and the world that reads it, or the
   processes of a run, must have in common. It consists of the fields that influence a run. Fields
   whose row is marked DEMI_FREE may differ (threads, allocator, allow_large_dt, user pointers). A
   checkpoint holds the values, so that an error message can name the field and both values.
   --------------------------------------------------------------------------------------------- */
/* --- values of fields as bytes of a file and as words; changes of a checkpoint, slabs and reports
       show them. --- */
enum { DEMI_ROW_MOST = DEM_GROUPS*24 };         /* bytes of a field in the file, at most */
/* Writes the value of a field to `out` in the form of the file, r->size bytes. */
static void demi_row_value(const demi_field_row *r, const void *item, void *out) {
    const char *at = (const char *)item + r->offset, *text;
    memset(out, 0, r->size);
    if (r->type == 'h') {
        const uint64_t digest = r->digest(item);
        memcpy(out, &digest, sizeof digest);
    } else if (r->type == 'p') {
        char none[sizeof(void (*)(void))] = "";
        const int32_t one = memcmp(at, none, sizeof none) != 0;
        memcpy(out, &one, sizeof one);
    } else if (r->type == 't') {
        memcpy(&text, at, sizeof text);
        if (text) strncpy((char *)out, text, r->size - 1);
    } else memcpy(out, at, r->size);
}
/* Prints element k of a value in the form of the file, for an error message. digits: significant
   digits of reals. */
static void demi_row_print(const demi_field_row *r, const char *value, size_t k, int digits,
                                 char *out, size_t size) {
    const char *word = r->words;
    int32_t i = 0;
    uint64_t u;
    dem_real x;
    double d;
    switch (r->type) {
    case 'i': case 'e': case 'p':
        memcpy(&i, value + 4*k, sizeof i);
        for (word = r->type == 'i' ? 0 : word; word && i > 0; i--)
            word = strchr(word, ' ') ? strchr(word, ' ') + 1 : 0;
        if (word) { demi_words(out, size, "%.*s", (int)strcspn(word, " "), word); break; }
        memcpy(&i, value + 4*k, sizeof i);
        demi_words(out, size, "%ld", (long)i);
        break;
    case 'u':
        memcpy(&u, value + 8*k, sizeof u);
        demi_words(out, size, "%llu", (unsigned long long)u);
        break;
    case 'd':
        memcpy(&d, value + 8*k, sizeof d);
        demi_words(out, size, "%.*g", digits, d);
        break;
    case 't': demi_words(out, size, "\"%.40s\"", value); break;
    default:
        memcpy(&x, value + sizeof x*k, sizeof x);
        demi_words(out, size, "%.*g", digits, (double)x);
    }
}

/* Digests of the geometry of a shape, without values that are derived from it. Pieces are hashed
   member by member, because the struct has padding. */
static uint64_t demi_digest_spheres(const void *item) {
    const demi_shape *s = (const demi_shape *)item;
    return demi_hash(DEMI_HASH_START, s->parts, 4*(size_t)s->count*sizeof(dem_real));
}
static uint64_t demi_digest_hull(const void *item) {
    const demi_shape *s = (const demi_shape *)item;
    const uint64_t h = demi_hash(DEMI_HASH_START, s->hull, s->faces
                                 ? demi_shape_hull_reals(s)*sizeof(double) : 0);
    return demi_hash(h, s->rim, s->faces ? demi_shape_rim_ints(s)*sizeof(int32_t) : 0);
}
static uint64_t demi_digest_pieces(const void *item) {
    const demi_shape *s = (const demi_shape *)item;
    uint64_t h = DEMI_HASH_START;
    int k;
    for (k = 0; k < s->pieces; k++) {
        h = demi_hash(h, &s->piece[k].shape, sizeof s->piece->shape);
        h = demi_hash(h, &s->piece[k].at, sizeof s->piece->at);
        h = demi_hash(h, &s->piece[k].q, sizeof s->piece->q);
    }
    return h;
}
static const demi_field_row demi_shape_fields[] = {
    DEMI_ROW(demi_shape, kind, 'i'), DEMI_ROW_AS(demi_shape, "spheres", count, 'i'),
    DEMI_ROW(demi_shape, axes, 'v'), DEMI_ROW(demi_shape, inertia, 'v'),
    DEMI_ROW(demi_shape, volume, 'd'), DEMI_ROW(demi_shape, corners, 'i'),
    DEMI_ROW(demi_shape, faces, 'i'), DEMI_ROW(demi_shape, pieces, 'i'),
    DEMI_ROW_DIGEST("spheres", demi_digest_spheres), DEMI_ROW_DIGEST("faces", demi_digest_hull),
    DEMI_ROW_DIGEST("pieces", demi_digest_pieces), DEMI_ROW_END};

/* A part of a scene: a kind of items, each a struct with these rows. */
typedef struct demi_scene_part {
    const char *name, *many;         /* for error messages: of one item; of all */
    const demi_field_row *rows;
} demi_scene_part;
enum { DEMI_PART_PAIRS = 2, DEMI_PART_WALLS = 4, DEMI_PARTS = 8 };
static const demi_scene_part demi_scene_parts[DEMI_PARTS] = {
    {"", "descs", demi_world_desc_rows},
    {" of material", "materials", demi_material_rows},
    {" (dem_pair_set) of materials", "pairs of materials", demi_pair_rows},
    {" of shape", "shapes", demi_shape_fields},
    {" of wall", "walls", demi_wall_rows},
    {" of field", "fields", demi_field_rows},
    {" of feed", "feeds", demi_feed_rows},
    {" of outlet", "outlets", demi_outlet_rows}};
/* Writes the number of items of each part, in the order of demi_scene_parts. Walls that were
   removed count. */
static void demi_scene_counts(const dem_world *w, int32_t *counts) {
    counts[0] = 1;
    counts[1] = w->material_count;
    counts[DEMI_PART_PAIRS] = w->material_count*w->material_count;
    counts[3] = w->shape_count;
    counts[DEMI_PART_WALLS] = w->wall_count;
    counts[5] = w->field_count;
    counts[6] = w->feed_count;
    counts[7] = w->outlet_count;
}
/* Returns item i of a part: the struct that the part's rows describe. */
static const void *demi_scene_item(const dem_world *w, int part, int i) {
    const int n = w->material_count;
    switch (part) {
    case 0: return &w->asked;
    case 1: return &w->materials[i];
    case DEMI_PART_PAIRS: return &w->pairs[i/n*DEMI_MATERIALS + i%n].given;
    case 3: return &w->shapes[i];
    case DEMI_PART_WALLS: return &w->walls[i];
    case 5: return &w->fields[i].desc;
    case 6: return demi_feed_at(w, i);
    default: return &demi_outlet_at(w, i)->desc;
    }
}
/* Writes the scene, or counts or hashes its bytes, as the stream says. */
static void demi_visit_scene(const dem_world *w, demi_stream *s) {
    int32_t counts[DEMI_PARTS];
    char value[DEMI_ROW_MOST];
    int part, i;
    const demi_field_row *r;
    demi_scene_counts(w, counts);
    for (part = 0; part < DEMI_PARTS; part++)
        for (i = 0; i < counts[part]; i++)
            for (r = demi_scene_parts[part].rows; r->name; r++) {
                if (r->how & DEMI_FREE) continue;
                demi_row_value(r, demi_scene_item(w, part, i), value);
                demi_visit(s, value, r->size);
            }
}
/* Returns a digest of the scene. Processes compare it to check that they hold the same one. */
static uint64_t demi_scene_digest(const dem_world *w) {
    int32_t counts[DEMI_PARTS];
    demi_stream s = {0, 0, 0, DEMI_HASH_START, 0, 0, 0};
    demi_scene_counts(w, counts);
    demi_visit(&s, counts, sizeof counts);
    demi_visit_scene(w, &s);
    return s.sum;
}
