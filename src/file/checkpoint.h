/* ---------------------------------------------------------------------------------------------
   >>checkpoint
   Checkpoints: binary files with the complete state, from which a run continues bit for bit. The
   same functions (demi_visit_...) write and read the state, so that the two cannot differ. This
   part owns the file format, and reads the whole world.

   A file consists of
       head      magic, version, size of dem_real, byte order, digest of the layout, sizes, counts
       scene     the fields of desc, materials, pairs, shapes, walls, fields, feeds, outlets
       state     numbers, domains, bodies, neighbour lists, contacts, walls, features (>>features),
                 outputs
       checksum  of everything before it

   Some values are computed when the candidate list is built: the laws in force, the length of the
   contact history, and coefficients that dem_pair_set has since made out of date. The file contains
   them, because the scene may have changed since then and computing them again could give other
   values. If the list no longer fits the bodies, only its counts are stored: the next rebuild
   depends on them.
   --------------------------------------------------------------------------------------------- */
#define DEMI_CHECKPOINT_MAGIC "DEM-CKPT"
enum { DEMI_CHECKPOINT_VERSION = 28 };

/* --- the state, visited in the order in which it is checked --- */

/* Visits all numbers that are not in arrays. When writing, the records of outputs are those of the
   present outputs. */
static void demi_visit_numbers(dem_world *w, demi_stream *s) {
    DEMI_VISIT(s, w->bodies.count);          DEMI_VISIT(s, w->bodies.slot_count);
    DEMI_VISIT(s, w->domain_count);   DEMI_VISIT(s, w->join_room);
    if (!s->from) w->written_count = w->look.output_count;
    DEMI_VISIT(s, w->joint_count);    DEMI_VISIT(s, w->joint_last);
    DEMI_VISIT(s, w->rail_count);
    DEMI_VISIT(s, w->written_count);
    DEMI_VISIT(s, w->bodies.orienting);      DEMI_VISIT(s, w->bodies.shaped);
    DEMI_VISIT(s, w->filed.count);    DEMI_VISIT(s, w->filed.rows);
    DEMI_VISIT(s, w->filed.stride);
    DEMI_VISIT(s, w->bodies.slot_free);      DEMI_VISIT(s, w->bodies.slot_pending);
    DEMI_VISIT(s, w->bodies.balance);        DEMI_VISIT(s, w->desc.search);
    DEMI_VISIT(s, w->desc.gravity);          DEMI_VISIT(s, w->desc.dt);
    DEMI_VISIT(s, w->clock);          DEMI_VISIT(s, w->stage);
    DEMI_VISIT(s, w->margin);         DEMI_VISIT(s, w->effects);
    DEMI_VISIT(s, w->levels);         DEMI_VISIT(s, w->booked);
    DEMI_VISIT(s, w->events.n);
    DEMI_VISIT(s, w->desc.domain);    DEMI_VISIT(s, w->cell);
}
/* Visits the arrays of bodies that demi_body_arrays declares as state. */
static void demi_visit_bodies(dem_world *w, demi_stream *s) {
    int k;
    for (k = 0; k < DEMI_BODY_ARRAYS; k++) {
        const demi_body_array *a = &demi_body_arrays[k];
        const size_t n = (size_t)(a->who == DEMI_SLOTS ? w->bodies.slot_count : w->bodies.count);
        if (a->what && demi_has(w, a)) demi_visit(s, demi_data(w, a), n*demi_item(w, a));
    }
}
/* Visits the pruned neighbour list of domain d. The file counts a pair's candidate (k) from the
   first candidate of the domain. */
static void demi_visit_near(dem_world *w, demi_stream *s, int d) {
    const demi_domain *domain = &w->domains[d];
    const size_t from = (size_t)d*(size_t)w->near.stride, r = sizeof(dem_real);
    const size_t remembering = (size_t)domain->near_end, all = (size_t)domain->near_shaped_end;
    int p, e, l;
    demi_visit(s, w->near.a + from, 4*all);
    demi_visit(s, w->near.b + from, 4*all);
    if (w->effects.clustered) {
        demi_visit(s, w->near.ball_a + from, 4*remembering);
        demi_visit(s, w->near.ball_b + from, 4*remembering);
    }
    for (l = 0; l < 4; l++) {                   /* four stretches, with unused entries between */
        const int begin = l == 0 ? 0 : l == 1 ? domain->near_cross
            : l == 2 ? domain->near_shaped : domain->near_shaped_cross;
        const int end = l == 0 ? domain->near_own : l == 1 ? domain->near_end
            : l == 2 ? domain->near_shaped_cross : domain->near_shaped_end;
        for (p = begin; p < end; p++) {
            const int32_t first = d*(l & 1 ? w->cross.stride : w->own.stride);
            int32_t k = s->from ? 0 : w->near.k[from + (size_t)p] - first;
            demi_visit(s, &k, sizeof k);
            if (s->from) w->near.k[from + (size_t)p] = k;      /* demi_near_check adds `first` */
        }
    }
    for (e = 0; e < w->memory_stride; e++)
        demi_visit(s, w->near.memory + (from*(size_t)w->memory_stride +
                   (size_t)e*(size_t)w->near.stride), remembering*r);
    for (e = 0; e < demi_coef_columns(w) && w->stage.pairs_changed && demi_many_species(w); e++)
        demi_visit(s, w->near.coef + (from*DEMI_PAIR_COLUMNS + (size_t)e*(size_t)w->near.stride),
                   remembering*r);
}
/* Visits candidate pairs, pruned neighbour lists and candidates on walls, if the list fits the
   bodies. */
static void demi_visit_lists(dem_world *w, demi_stream *s) {
    const int n = w->effects.species_count;
    int d, i;
    if (w->stage.list_valid && w->stage.pairs_changed && !demi_many_species(w))
        demi_visit(s, w->species_coef, (size_t)(n*n*DEMI_PAIR_COLUMNS)*sizeof(dem_real));
    for (d = 0; d < w->domain_count && w->stage.list_valid; d++) {
        const demi_domain *domain = &w->domains[d];
        const size_t walls = (size_t)domain->walls;
        for (i = 0; i < 2; i++) {
            demi_list *list = i ? &w->cross : &w->own;
            const size_t from = (size_t)d*(size_t)list->stride;
            const size_t pairs = (size_t)(i ? domain->cross : domain->own);
            if (!pairs) continue;
            demi_visit(s, list->a + from, 4*pairs);
            demi_visit(s, list->b + from, 4*pairs);
        }
        if (domain->near_shaped_end) demi_visit_near(w, s, d);
        if (!walls) continue;
        demi_visit(s, w->wall_body + d*w->wall_stride, walls*4);
        demi_visit(s, w->wall_id + d*w->wall_stride, walls*4);
        demi_visit(s, w->wall_element + d*w->wall_stride, walls*4);
        demi_visit(s, w->wall_gap + d*w->wall_stride, walls*sizeof(dem_real));
        demi_visit(s, w->wall_shift + 3*(size_t)d*(size_t)w->wall_stride, 3*walls*sizeof(dem_real));
        demi_visit(s, w->wall_cell + d*w->wall_stride, walls*4);
    }
}
/* Visits persistent contacts, with or without a list, and the contact history of spheres that is
   saved between two lists (demi_filed). */
static void demi_visit_contacts(dem_world *w, demi_stream *s) {
    int d, k;
    for (d = 0; d < w->domain_count; d++) {
        const demi_domain *domain = &w->domains[d];
        for (k = 0; k < domain->persistent && !s->from; k++)
            demi_persistent_tidy(w, demi_persistent_of(w, d) + k);
        if (domain->persistent)
            demi_visit(s, demi_persistent_of(w, d),
                       (size_t)domain->persistent*sizeof(demi_persistent));
    }
    if (w->stage.list_valid || !w->filed.count) return;
    demi_visit(s, w->filed.start, ((size_t)w->filed.rows + 1)*4);
    demi_visit(s, w->filed.partner, (size_t)w->filed.count*4);
    demi_visit(s, w->filed.part, (size_t)w->filed.count*4);
    demi_visit(s, w->filed.memory, (size_t)w->filed.count*(size_t)w->filed.stride*sizeof(dem_real));
}
/* Visits poses, loads, user-defined numbers and motions of walls. Their geometry belongs to the
   scene. */
static void demi_visit_walls(dem_world *w, demi_stream *s) {
    int i;
    for (i = 0; i < w->wall_count; i++) {
        demi_wall *wall = &w->walls[i];
        const demi_field_row *r = demi_motion_rows; /* pointers stay those of the reading world */
        demi_visit(s, &wall->home, sizeof wall->home);
        demi_visit(s, &wall->pose, sizeof wall->pose);
        demi_visit(s, &wall->mid, sizeof wall->mid);
        demi_visit(s, &wall->ahead, sizeof wall->ahead);
        demi_visit(s, &wall->was, sizeof wall->was);
        demi_visit(s, &wall->loads, sizeof wall->loads);
        demi_visit(s, wall->reals, sizeof wall->reals);
        demi_visit(s, &wall->servo, sizeof wall->servo);
        demi_visit(s, &wall->idle, sizeof wall->idle);
        demi_visit(s, &wall->glide, sizeof wall->glide);
        demi_visit(s, &wall->glides, sizeof wall->glides);
        for (; r->how & DEMI_LIMITS; r++) demi_visit(s, (char *)&wall->motion + r->offset, r->size);
    }
}
/* Visits the records of what outputs have written. */
static void demi_visit_outputs(dem_world *w, demi_stream *s) {
    int i;
    for (i = 0; i < w->written_count; i++)
        demi_visit(s, s->from ? &w->written[i] : &w->look.outputs[i].written, sizeof *w->written);
}
/* Visits the whole state. demi_twin_read reads it in the same order. */
static void demi_visit_state(dem_world *w, demi_stream *s) {
    int d;
    demi_visit_numbers(w, s);
    for (d = 0; d < w->domain_count; d++) {
        w->domains[d].coefs = 0;                /* see demi_persistent_tidy */
        w->domains[d].check = 0;                /* of the last step, which it has passed */
    }
    demi_visit(s, w->domains, (size_t)w->domain_count*sizeof(demi_domain));
    demi_visit_bodies(w, s);
    demi_visit_lists(w, s);
    demi_visit_contacts(w, s);
    demi_visit_walls(w, s);
    DEMI_ALL_FEATURES(visit, (w, s))
    demi_visit_outputs(w, s);
}

/* --- writing --- */

/* The beginning of a file. */
typedef struct demi_checkpoint_head {
    char magic[8];
    uint32_t version, real_size, byte_order, int_size;    /* int_size: demi_checkpoint_layout */
    uint64_t body_size;             /* bytes that follow the head, without the checksum */
    int32_t parts[DEMI_PARTS];      /* demi_scene_counts; the scene follows the head */
} demi_checkpoint_head;

/* Returns a digest of the sizes of structs that are saved whole, of the rows of the scene and of
   the arrays of bodies. It differs for another dem.h, another memory layout of the compiler and
   another DEM_DOMAIN_BODIES. */
static uint32_t demi_checkpoint_layout(void) {
    const size_t sizes[] = {sizeof(demi_domain), sizeof(demi_persistent), sizeof(demi_timing),
                            sizeof(demi_stages), sizeof(demi_margin), sizeof(demi_in_force),
                            sizeof(demi_levels), sizeof(demi_booked), sizeof(demi_strained),
                            sizeof(demi_joint), sizeof(demi_rail), sizeof(demi_written),
                            sizeof(demi_event_counts), sizeof(demi_ongoing), sizeof(demi_sums),
                            sizeof(demi_impacts), (size_t)DEM_DOMAIN_BODIES};
    uint64_t h = demi_hash(DEMI_HASH_START, sizes, sizeof sizes);
    const demi_field_row *r;
    int k;
    for (k = 0; k < DEMI_PARTS; k++)
        for (r = demi_scene_parts[k].rows; r->name; r++)
            if (!(r->how & DEMI_FREE))
                h = demi_hash(demi_hash(h, r->name, strlen(r->name)), &r->size, sizeof r->size);
    for (k = 0; k < DEMI_BODY_ARRAYS; k++) {
        const size_t row[] = {demi_body_arrays[k].item, (size_t)demi_body_arrays[k].who,
                              (size_t)demi_body_arrays[k].what};
        h = demi_hash(h, row, sizeof row);
    }
    return (uint32_t)(h ^ h >> 32);
}
/* Returns the first body whose state is not finite or whose position is beyond DEMI_FARTHEST; -1 if
   there is none. */
static int demi_body_lost(const dem_world *w) {
    int i, k;
    size_t e;
    for (i = 0; i < w->bodies.count; i++) {
        for (k = 0; k < DEMI_BODY_ARRAYS; k++) {
            const demi_body_array *a = &demi_body_arrays[k];
            const dem_real *x;
            if (a->what < DEMI_REALS || !demi_has(w, a)) continue;
            x = (const dem_real *)(const void *)demi_datum(w, a, i);
            for (e = 0; e < demi_item(w, a)/sizeof *x; e++) if (!demi_finite(x[e])) return i;
        }
        if (demi_size(demi_at(w->bodies.pos + 4*i)) > DEMI_FARTHEST) return i;
    }
    return -1;
}
/* Empties a file of contact histories that is out of date, since the lists hold them. */
static void demi_filed_current(const dem_world *w, demi_filed *filed) {
    if (w->stage.list_valid) filed->count = 0;
    if (!filed->count) filed->rows = filed->stride = 0;
}
DEM_API dem_result dem_checkpoint_write(dem_world *w, const char *path) {
    if (demi_null_write(w, __func__, w, "world")) return DEM_ERROR_ARGUMENT;
    const int lost = demi_body_lost(w);
    demi_checkpoint_head head;
    demi_out out;
    demi_stream s = {0, 0, 0, 0, 0, 0, 0};
    dem_result result;
    uint64_t sum;
    if (lost >= 0)
        return demi_refuse(w, __func__, "body %u no longer has a finite position, "
                           "velocity and force: the run has blown up; go back to an earlier "
                           "checkpoint; %s was not changed", (unsigned)w->bodies.slot[lost] + 1,
                           path ? path : "the file");
    result = demi_out_open(&out, w, __func__, path);
    if (result != DEM_OK) return result;
    demi_filed_current(w, &w->filed);
    memset(&head, 0, sizeof head);
    memcpy(head.magic, DEMI_CHECKPOINT_MAGIC, 8);
    head.version = DEMI_CHECKPOINT_VERSION;
    head.real_size = (uint32_t)sizeof(dem_real);
    head.byte_order = 0x01020304u;
    head.int_size = demi_checkpoint_layout();
    demi_scene_counts(w, head.parts);
    demi_visit_scene(w, &s);                    /* counts */
    demi_visit_state(w, &s);
    head.body_size = s.size;
    s.file = out.file;
    s.sum = DEMI_HASH_START;
    demi_visit(&s, &head, sizeof head);
    demi_visit_scene(w, &s);
    demi_visit_state(w, &s);
    sum = s.sum;
    fwrite(&sum, 1, sizeof sum, out.file);
    return demi_out_close(&out);
}

/* --- reading: is the file a complete checkpoint of this scene? --- */

/* Checks that the data are a complete checkpoint, undamaged, and written by a program with the same
   layout; copies the head to *head. Nothing behind the head is used before these checks succeed. */
static dem_result demi_checkpoint_check(dem_world *w, const char *path, const char *data,
                                        size_t size, demi_checkpoint_head *head) {
    const char *call = "dem_checkpoint_read";
    uint64_t sum;
    if (size < sizeof *head + sizeof sum || memcmp(data, DEMI_CHECKPOINT_MAGIC, 8))
        return demi_fail(w, DEM_ERROR_FORMAT, "%s: %.200s: %s; write checkpoints with "
                         "dem_checkpoint_write", call, path,
                         size >= 8 && !memcmp(data, DEMI_CHECKPOINT_MAGIC, 8)
                         ? "is cut short within its header" : "is not a checkpoint");
    memcpy(head, data, sizeof *head);
    if (head->byte_order != 0x01020304u || head->version != DEMI_CHECKPOINT_VERSION)
        return demi_fail(w, DEM_ERROR_FORMAT, "%s: %.200s: has checkpoint version %u%s, must be "
                         "%d; read it with the dem.h that wrote it", call, path,
                         (unsigned)head->version, head->byte_order != 0x01020304u
                         ? " and another byte order" : "", (int)DEMI_CHECKPOINT_VERSION);
    if (head->real_size != sizeof(dem_real))
        return demi_fail(w, DEM_ERROR_FORMAT, "%s: %.200s: was written with DEM_REAL of %u bytes, "
                         "must be %u; build with the same precision", call, path,
                         (unsigned)head->real_size, (unsigned)sizeof(dem_real));
    if (head->body_size != (uint64_t)(size - sizeof *head) - sizeof sum)
        return demi_fail(w, DEM_ERROR_FORMAT, "%s: %.200s: has %llu bytes, must be %llu; it was "
                         "cut short or appended to: use another copy or an older checkpoint", call,
                         path, (unsigned long long)size,
                         (unsigned long long)(sizeof *head + head->body_size + sizeof sum));
    memcpy(&sum, data + size - sizeof sum, sizeof sum);
    if (sum != demi_hash(DEMI_HASH_START, data, size - sizeof sum))
        return demi_fail(w, DEM_ERROR_FORMAT, "%s: %.200s: its checksum does not match its "
                         "contents; the file is damaged: use another copy or an older checkpoint",
                         call, path);
    if (head->int_size != demi_checkpoint_layout())
        return demi_fail(w, DEM_ERROR_FORMAT, "%s: %.200s: was written by another dem.h, or by a "
                         "compiler with another memory layout; read it with a program built like "
                         "the one that wrote it", call, path);
    return DEM_OK;
}
/* Fails with an error message that names a field and its values in the file (`there`) and in this
   world (`here`). of: the item, such as " of wall 2". */
static dem_result demi_row_differs(dem_world *w, const char *path, const demi_field_row *r,
                                   const char *there, const char *here, const char *of) {
    static const char *const axes[] = {".x", ".y", ".z", ".lo.x", ".lo.y", ".lo.z", ".hi.x",
                                       ".hi.y", ".hi.z"};
    const size_t item = demi_row_item(r), count = r->size/item;
    size_t k = 0;
    char a[48], b[48], which[24] = "";
    const char *advice = "create the world with the same desc, materials, pairs, shapes, walls, "
        "motions, fields, feeds and outlets as the one that wrote it, then read";
    while (k + 1 < count && !memcmp(there + item*k, here + item*k, item)) k++;
    if (r->type == 'h')
        return demi_fail(w, DEM_ERROR_FORMAT, "dem_checkpoint_read: %.200s: belongs to another "
                         "scene: written with other %s%s than those of this world; %s", path,
                         r->name, of, advice);
    if (r->type == 'v') demi_words(which, sizeof which, "%s", axes[count == 6 ? k + 3 : k]);
    else if (count > 1) demi_words(which, sizeof which, "[%d]", (int)k);
    demi_row_print(r, there, k, 6, a, sizeof a);
    demi_row_print(r, here, k, 6, b, sizeof b);
    if (!strcmp(a, b)) {
        demi_row_print(r, there, k, 17, a, sizeof a);
        demi_row_print(r, here, k, 17, b, sizeof b);
    }
    return demi_fail(w, DEM_ERROR_FORMAT, "dem_checkpoint_read: %.200s: belongs to another scene: "
                     "written with %s%s %s%s, this world has %s; %s", path, r->name, which, a, of,
                     b, advice);
}
/* Compares the scene of the file with that of the world, and fails if they differ. The file may
   describe a wall as removed that still exists here: it is then removed in the twin. */
static dem_result demi_checkpoint_scene(dem_world *w, dem_world *twin, const char *path,
                                        demi_stream *s, const int32_t *parts) {
    int32_t counts[DEMI_PARTS];
    char here[DEMI_ROW_MOST], there[DEMI_ROW_MOST], of[80];
    int part, i, gone;
    const demi_field_row *r;
    demi_scene_counts(w, counts);
    for (part = 0; part < DEMI_PARTS; part++)
        if (parts[part] != counts[part])
            return demi_fail(w, DEM_ERROR_FORMAT, "dem_checkpoint_read: %.200s: belongs to another "
                             "scene: the checkpoint has %d %s, this world %d (removed ones count); "
                             "create the world like the one that wrote it, then read", path,
                             (int)parts[part], demi_scene_parts[part].many, (int)counts[part]);
    for (part = 0; part < DEMI_PARTS; part++)
        for (i = gone = 0; i < counts[part]; i++)
            for (r = demi_scene_parts[part].rows; r->name; r++) {
                const int n = w->material_count;
                if (r->how & DEMI_FREE) continue;
                demi_row_value(r, demi_scene_item(w, part, i), here);
                demi_visit(s, there, r->size);
                if (part == DEMI_PART_WALLS && r == demi_wall_rows) {
                    int32_t kind;
                    memcpy(&kind, there, sizeof kind);
                    gone = kind == DEMI_WALL_NONE;
                    if (gone) memset(&twin->walls[i], 0, sizeof twin->walls[i]);
                    else if (w->walls[i].kind == DEMI_WALL_NONE)
                        return demi_fail(w, DEM_ERROR_FORMAT, "dem_checkpoint_read: %.200s: "
                                         "belongs to another scene: wall %d was removed here but "
                                         "exists there; read before you remove it", path,
                                         (int)w->walls[i].id);
                }
                if (gone && r == demi_wall_rows + 1) {
                    dem_wall last;                      /* later ids continue from the larger one */
                    memcpy(&last.id, there, sizeof last.id);
                    if (last.id < 1 || demi_wall_place(last) != i)
                        return demi_fail(w, DEM_ERROR_FORMAT, "dem_checkpoint_read: %.200s: the "
                                         "removed wall in place %d has the id %d, which names "
                                         "another place; the file is damaged: use another copy or "
                                         "an older checkpoint", path, i + 1, (int)last.id);
                    twin->walls[i].id = DEMI_MAX(last.id, w->walls[i].id);
                }
                if (gone || !memcmp(here, there, r->size)) continue;
                if (part == DEMI_PART_PAIRS)
                    demi_words(of, sizeof of, "%s %d and %d", demi_scene_parts[part].name, i/n + 1,
                               i%n + 1);
                else demi_words(of, sizeof of, part ? "%s %d" : "%s", demi_scene_parts[part].name,
                                i + 1);
                return demi_row_differs(w, path, r, there, here, of);
            }
    return DEM_OK;
}
