/* ---------------------------------------------------------------------------------------------
   >>rows
   One row for each field of a desc, of a scene and of the numbers that a run changes: its name,
   unit, offset and limits, and how it is used. Loops over rows check the arguments of calls and the
   numbers in a checkpoint, write and compare scenes, and exchange numbers with slabs. A table is
   here or in the part that owns the struct, and ends with DEMI_ROW_END. A field without a row fails
   tests/core/test_rows.c.
   --------------------------------------------------------------------------------------------- */

/* Range of a number: 0 means unchecked, DEMI_ANY finite, DEMI_FROM >= 0, DEMI_OVER > 0; DEMI_UNDER
   excludes the value `most`. DEMI_FREE: the field is not part of the scene; examples are `threads`
   and the pointers passed to user-defined functions. */
enum { DEMI_ANY = 1, DEMI_FROM = 2, DEMI_OVER = 4, DEMI_LIMITS = 7, DEMI_UNDER = 8,
       DEMI_FREE = 16 };
/* How slabs exchange a field. DEMI_TO_SLAB, DEMI_TO_HEAD: each slab, or the head that they share,
   begins with the world's value. DEMI_HEADS, DEMI_FIRSTS: collecting gives the world the value of
   the head, or of the first slab. DEMI_SUM, DEMI_LARGEST, DEMI_EITHER: it gives the world the sum
   over slabs, the largest value, or the bits that are set in any slab. */
enum { DEMI_TO_SLAB = 32, DEMI_TO_HEAD = 64, DEMI_HEADS = 128, DEMI_FIRSTS = 256,
       DEMI_SUM = 512, DEMI_LARGEST = 1024, DEMI_EITHER = 2048,
       DEMI_DEALT = DEMI_TO_SLAB | DEMI_TO_HEAD | DEMI_HEADS };
/* dem_world_report prints this field of a dem_world_desc if it is not 0. */
enum { DEMI_PRINTED = 1 << 20 };
/* Returned by `zero`: the limits decide whether the field may be 0; it may be 0; it must be 0. */
enum { DEMI_0_NOT, DEMI_0_TOO, DEMI_0_ALONE };
/* One field. type: 'i' int, 'e' enum, 'r' dem_real, 'v' dem_vec3 or dem_box, 'd' double,
   'u' uint64_t, 'p' whether a pointer is null, 't' a text of at most `size` bytes, 'h' a digest
   computed by `digest`. */
typedef struct demi_field_row {
    const char *name, *words;       /* words: names of an enum's values, from 0; of a number: a
                                       further limit, for the error message */
    size_t offset, size;            /* offset in its struct; size in a checkpoint, bytes */
    char type;
    uint64_t (*digest)(const void *item);
    int how;
    double most;                    /* largest magnitude */
    const char *unit;
    /* other > 0: the value must be 0 or above the field `other` rows before this one (DEMI_FROM:
       not below it). other < 0 names a field after this one; it and `kinds` are read by `zero`. */
    int other, kinds;
    int (*zero)(const dem_world *w, const void *item, const struct demi_field_row *r);
    const char *refusal;            /* of a dem_world_desc: the whole error message; else the
                                       remedy in it, null: that of the call */
} demi_field_row;
#define DEMI_WHERE(of, field) offsetof(of, field), sizeof ((of *)0)->field
#define DEMI_ROW_AS(of, name, field, type) \
    {name, 0, DEMI_WHERE(of, field), type, 0, 0, 0, "", 0, 0, 0, 0}
#define DEMI_ROW(of, field, type) DEMI_ROW_AS(of, #field, field, type)
#define DEMI_ROW_FREE(of, field) DEMI_LIMITED(of, field, 'p', DEMI_FREE, 0, "")
#define DEMI_ROW_ENUM(of, field, how, refusal, words) \
    {#field, words, DEMI_WHERE(of, field), 'e', 0, how, 0, "", 0, 0, 0, refusal}
#define DEMI_ROW_NULL(of, field) \
    {#field, "none one", offsetof(of, field), sizeof(int32_t), 'p', 0, 0, 0, "", 0, 0, 0, 0}
#define DEMI_ROW_TEXT(of, field, most) \
    {#field, 0, offsetof(of, field), (most)*24, 't', 0, 0, 0, "", 0, 0, 0, 0}
#define DEMI_ROW_DIGEST(name, digest) \
    {name, 0, 0, sizeof(uint64_t), 'h', digest, 0, 0, "", 0, 0, 0, 0}
#define DEMI_ROW_END {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}
/* A number with limits; DEMI_LIMITED_IF: limits that depend on another field or on `zero`. */
#define DEMI_LIMITED(of, field, type, how, most, unit) \
    DEMI_LIMITED_IF(of, field, type, how, most, unit, 0, 0, 0, 0)
#define DEMI_LIMITED_IF(of, field, type, how, most, unit, words, other, kinds, zero) \
    {#field, words, DEMI_WHERE(of, field), type, 0, how, most, unit, other, kinds, zero, 0}

/* Size of one element of a field in a checkpoint, bytes. A vector has several elements. */
static size_t demi_row_item(const demi_field_row *r) {
    switch (r->type) {
    case 't': return r->size;
    case 'd': case 'u': case 'h': return 8;
    case 'i': case 'e': case 'p': return 4;
    default: return sizeof(dem_real);
    }
}
/* Returns element k of a number as a double. */
static double demi_row_read(const demi_field_row *r, const void *item, int k) {
    const char *at = (const char *)item + r->offset + (size_t)k*demi_row_item(r);
    int32_t i;
    dem_real x;
    double d;
    switch (r->type) {
    case 'i': case 'e': memcpy(&i, at, sizeof i); return i;
    case 'd': memcpy(&d, at, sizeof d); return d;
    default: memcpy(&x, at, sizeof x); return (double)x;
    }
}
/* Returns the largest magnitude allowed; for an enum its last value. */
static double demi_row_most(const demi_field_row *r) {
    const char *word = r->words;
    double most = r->most;
    if (r->type == 'e') for (most = 0; *word; word++) most += *word == ' ';
    return most;
}
/* True if x is within the limits of this field. `item` is the struct that contains it. */
static int demi_row_good(const dem_world *w, const demi_field_row *r, const void *item, double x) {
    const int zero = r->zero ? r->zero(w, item, r) : r->other > 0;
    const double least = r->other > 0 ? demi_row_read(r - r->other, item, 0) : 0;
    const double most = demi_row_most(r);
    if (!demi_finite_double(x) || fabs(x) > most || (r->how & DEMI_UNDER && !(x < most))) return 0;
    if (!(fabs(x) > 0)) return zero || !(r->how & DEMI_OVER);
    return zero != DEMI_0_ALONE &&
        (r->how & DEMI_OVER ? x > least : r->how & DEMI_FROM ? x >= least : 1);
}
/* Returns the first field out of its limits and sets *k to the element; null if all are good. */
static const demi_field_row *demi_rows_bad(const dem_world *w, const demi_field_row *r,
                                           const void *item, int *k) {
    for (; r->name; r++)
        for (*k = 0; r->how & DEMI_LIMITS && *k < (int)(r->size/demi_row_item(r)); ++*k)
            if (!demi_row_good(w, r, item, demi_row_read(r, item, *k))) return r;
    return 0;
}
/* Fails with a message about the first field out of its limits. `of` is "" or says which desc, such
   as " of materials 1 and 2". `remedy` ends the message unless the row has its own. */
static dem_result demi_rows_check(dem_world *w, const char *call, const demi_field_row *rows,
                                  const void *item, const char *of, const char *remedy) {
    int k;
    const demi_field_row *r = demi_rows_bad(w, rows, item, &k);
    char least[80], words[80] = "", most[24] = "finite";
    const char *gap;
    if (!r) return DEM_OK;
    gap = *r->unit ? " " : "";
    if (r->other > 0)
        demi_words(least, sizeof least, "%s (%g%s%s)", r[-r->other].name,
                   demi_row_read(r - r->other, item, 0), gap, r->unit);
    else demi_words(least, sizeof least, "%g%s%s", r->how & DEMI_ANY ? -r->most : 0, gap, r->unit);
    if (r->words && r->type != 'e') demi_words(words, sizeof words, ", %s,", r->words);
    if (demi_row_most(r) < DBL_MAX)
        demi_words(most, sizeof most, "%s %g", r->how & DEMI_UNDER ? "<" : "<=", demi_row_most(r));
    return demi_refuse(w, call, "%s%s is %g%s%s, must be %s%s %s%s and %s%s; %s", r->name, of,
                       demi_row_read(r, item, k), gap, r->unit, r->other > 0 ? "0 or " : "",
                       r->how & DEMI_OVER ? ">" : ">=", least, words, most,
                       r->how & DEMI_OVER && r->other <= 0 ? " (required)" : "",
                       r->refusal ? r->refusal : remedy);
}

/* --- numbers of a world that a run changes. Reading a checkpoint checks them against these
       limits. --- */
#define DEMI_N(field, type, how) DEMI_LIMITED(DEMI_OF, field, type, how, DBL_MAX, "")
#define DEMI_OF dem_world
static const demi_field_row demi_number_rows[] = {
    /* as dem_world_gravity_set and dem_world_dt_set have left them */
    DEMI_N(desc.gravity, 'v', DEMI_ANY | DEMI_TO_SLAB | DEMI_HEADS),
    DEMI_N(desc.dt, 'r', DEMI_FROM | DEMI_TO_SLAB | DEMI_HEADS),
    DEMI_LIMITED(DEMI_OF, clock.time, 'd', DEMI_ANY | DEMI_DEALT, DEMI_FARTHEST, ""),
    DEMI_LIMITED(DEMI_OF, clock.since.time, 'd', DEMI_ANY | DEMI_DEALT, DEMI_FARTHEST, ""),
    DEMI_N(clock.since.steps, 'u', DEMI_DEALT), DEMI_N(clock.since.dt, 'd', DEMI_FROM | DEMI_DEALT),
    DEMI_N(clock.steps, 'u', DEMI_DEALT), DEMI_N(clock.rebuilds, 'u', DEMI_DEALT),
    DEMI_N(clock.last_rebuild, 'u', DEMI_HEADS), DEMI_N(clock.dt, 'r', DEMI_FROM | DEMI_DEALT),
    DEMI_N(clock.run_end, 'd', DEMI_ANY), DEMI_N(clock.run_steps, 'u', 0),
    DEMI_N(clock.half_kick, 'd', DEMI_FROM | DEMI_TO_SLAB | DEMI_FIRSTS),
    DEMI_N(clock.assumed_speed, 'd', DEMI_FROM | DEMI_DEALT),
    DEMI_N(clock.press_due, 'u', 0), DEMI_N(clock.press_since, 'u', 0),
    DEMI_N(clock.held, 'u', 0), DEMI_N(clock.grown, 'd', DEMI_ANY | DEMI_DEALT),
    DEMI_N(stage.dt_valid, 'i', DEMI_DEALT), DEMI_N(stage.list_valid, 'i', 0),
    DEMI_N(stage.pairs_changed, 'i', DEMI_TO_HEAD | DEMI_HEADS),
    DEMI_N(stage.forces_valid, 'i', DEMI_HEADS),
    DEMI_N(stage.primed, 'i', DEMI_DEALT), DEMI_N(stage.moved, 'i', DEMI_HEADS),
    DEMI_N(stage.synced, 'i', DEMI_FIRSTS), DEMI_N(stage.near_stale, 'i', 0),
    DEMI_N(stage.quiet, 'i', 0),
    DEMI_N(stage.skin_chosen, 'i', 0), DEMI_N(stage.near_chosen, 'i', 0),
    DEMI_N(margin.skin, 'd', DEMI_FROM | DEMI_DEALT), DEMI_N(margin.step_gone, 'd', 0),
    DEMI_N(margin.gone, 'd', DEMI_FROM | DEMI_HEADS), DEMI_N(margin.age, 'd', DEMI_FROM),
    DEMI_N(margin.walls_gone, 'd', DEMI_FROM | DEMI_HEADS), DEMI_N(margin.reach, 'd', DEMI_FROM),
    DEMI_N(margin.skin_auto, 'd', DEMI_FROM | DEMI_DEALT), DEMI_N(margin.creep, 'd', DEMI_FROM),
    DEMI_N(margin.span, 'd', DEMI_FROM | DEMI_TO_SLAB), DEMI_N(margin.change, 'd', DEMI_FROM),
    DEMI_N(margin.slack, 'd', DEMI_FROM | DEMI_TO_SLAB),
    DEMI_N(margin.pace, 'd', DEMI_FROM), DEMI_N(margin.walls_pace, 'd', DEMI_FROM),
    DEMI_N(margin.seen, 'd', DEMI_FROM), DEMI_N(margin.cover, 'd', DEMI_FROM),
    DEMI_N(margin.last_change, 'd', DEMI_FROM), DEMI_N(wall_fastest, 'd', DEMI_TO_SLAB),
    DEMI_N(effects.radius_min, 'r', DEMI_FROM), DEMI_N(effects.radius_max, 'r', DEMI_FROM),
    DEMI_N(bodies.balance, 'u', DEMI_TO_SLAB | DEMI_TO_HEAD),
    DEMI_N(desc.domain, 'v', DEMI_ANY), DEMI_N(cell.desc, 'r', DEMI_ANY),
    DEMI_N(cell.mid, 'd', DEMI_ANY), DEMI_N(cell.side, 'd', DEMI_FROM),
    DEMI_N(cell.offset, 'd', DEMI_ANY), DEMI_N(cell.rate, 'd', DEMI_ANY),
    DEMI_N(cell.shear, 'd', DEMI_ANY), DEMI_N(cell.strain, 'd', DEMI_ANY),
    DEMI_N(cell.sheared, 'd', DEMI_ANY), DEMI_N(cell.stress, 'd', DEMI_ANY),
    DEMI_N(cell.stiffness, 'd', DEMI_FROM), DEMI_N(cell.damping, 'd', DEMI_FROM),
    DEMI_N(cell.squeeze, 'd', DEMI_FROM), DEMI_N(cell.on, 'i', 0), DEMI_N(cell.none, 'i', 0),
    DEMI_ROW_END};
#undef DEMI_OF
#define DEMI_OF demi_booked
static const demi_field_row demi_booked_rows[] = {
    DEMI_N(energy, 'd', DEMI_TO_SLAB | DEMI_SUM), DEMI_N(inserted, 'd', DEMI_TO_SLAB | DEMI_SUM),
    DEMI_N(removed, 'd', DEMI_TO_SLAB | DEMI_SUM), DEMI_N(throughput, 'd', DEMI_TO_SLAB | DEMI_SUM),
    DEMI_N(overlap_max, 'd', DEMI_TO_SLAB | DEMI_LARGEST), DEMI_N(met, 'u', DEMI_EITHER),
    DEMI_N(crushed.next, 'd', DEMI_FROM | DEMI_TO_SLAB), DEMI_N(crushed.a, 'i', DEMI_TO_SLAB),
    DEMI_N(crushed.since, 'd', DEMI_ANY | DEMI_TO_SLAB), DEMI_N(crushed.b, 'i', DEMI_TO_SLAB),
    DEMI_N(crushed.time, 'd', DEMI_ANY | DEMI_TO_SLAB), DEMI_N(crushed.wall, 'i', DEMI_TO_SLAB),
    DEMI_N(crushed.none, 'i', 0),
    DEMI_N(speed_max, 'd', DEMI_FROM | DEMI_TO_SLAB | DEMI_HEADS), DEMI_N(due, 'd', 0),
    DEMI_N(residual, 'd', 0), DEMI_N(residual_rms, 'd', 0), DEMI_N(unsolved, 'u', 0),
    DEMI_N(sweeps, 'i', 0), DEMI_N(none, 'i', 0), DEMI_ROW_END};
#undef DEMI_OF
#define DEMI_OF dem_wall_loads
static const demi_field_row demi_loads_rows[] = {
    DEMI_N(force, 'v', DEMI_SUM), DEMI_N(torque, 'v', DEMI_SUM), DEMI_N(power, 'r', DEMI_SUM),
    DEMI_N(torque_axial, 'r', DEMI_SUM), DEMI_N(contacts, 'i', DEMI_SUM),
    DEMI_N(touched, 'i', DEMI_EITHER), DEMI_N(impulse, 'd', DEMI_SUM), DEMI_N(work, 'd', DEMI_SUM),
    DEMI_N(torque_impulse, 'd', DEMI_SUM), DEMI_N(time, 'd', 0), DEMI_N(rate, 'd', DEMI_SUM),
    DEMI_N(gained, 'd', DEMI_SUM), DEMI_ROW_END};
#undef DEMI_OF
#define DEMI_OF dem_outlet_state
static const demi_field_row demi_outlet_state_rows[] = {
    DEMI_N(count, 'u', DEMI_SUM), DEMI_N(total, 'u', DEMI_SUM), DEMI_N(mass, 'd', DEMI_SUM),
    DEMI_N(total_mass, 'd', DEMI_SUM), DEMI_N(sorted, 'u', DEMI_SUM), DEMI_N(gangue, 'u', DEMI_SUM),
    DEMI_N(sorted_mass, 'd', DEMI_SUM), DEMI_N(gangue_mass, 'd', DEMI_SUM), DEMI_N(since, 'd', 0),
    DEMI_N(last, 'd', DEMI_LARGEST), DEMI_N(back, 'u', DEMI_SUM), DEMI_N(held, 'u', DEMI_SUM),
    DEMI_N(back_total, 'u', DEMI_SUM), DEMI_N(held_total, 'u', DEMI_SUM),
    DEMI_N(back_mass, 'd', DEMI_SUM), DEMI_N(held_mass, 'd', DEMI_SUM),
    DEMI_N(back_total_mass, 'd', DEMI_SUM), DEMI_N(held_total_mass, 'd', DEMI_SUM),
    DEMI_N(residence, 'd', DEMI_SUM), DEMI_N(residence_square, 'd', DEMI_SUM),
    DEMI_N(residence_count, 'u', DEMI_SUM), DEMI_ROW_END};
#undef DEMI_OF

/* --- the desc of a world. It is checked before there is a world that could hold a message, so each
       limit has its message here. Laws, integrator, search, cone, solver and what depends on other
       fields: see dem_world_create_error_get. >>add-option: a field, a row, the code that reads
       the field. --- */
#define DEMI_ROW_OF(field, type) DEMI_ROW(dem_world_desc, field, type)
#define DEMI_ROW_SAID(field, type, how, most, text) {#field, 0, DEMI_WHERE(dem_world_desc, field), \
    type, 0, how, most, "", 0, 0, 0, "dem_world_create: " text}
#define DEMI_ROW_CHOICE(field, words) DEMI_ROW_ENUM(dem_world_desc, field, DEMI_FROM, \
    "dem_world_create: " #field " is not one of the enum values; start from DEM_WORLD_DESC", words)
static const demi_field_row demi_world_desc_rows[] = {
    DEMI_ROW_SAID(gravity, 'v', DEMI_ANY, DEMI_FARTHEST, "gravity is not finite or above 1e15 "
                  "m/s2; check how it was computed"), DEMI_ROW_OF(domain, 'v'),
    DEMI_ROW_CHOICE(boundary, "open periodic outflow"), DEMI_ROW_OF(planar, 'i'),
    DEMI_ROW_SAID(thickness, 'r', DEMI_FROM, DBL_MAX, "thickness must be >= 0 m; 0 means 1 m"),
    DEMI_ROW_CHOICE(response, "springs impulses"),
    DEMI_ROW_ENUM(dem_world_desc, normal_law, 0, 0, "hertz linear hysteretic"),
    DEMI_ROW_ENUM(dem_world_desc, tangent_law, 0, 0,
                  "auto none viscous step spring mindlin mindlin_rescaled"),
    DEMI_ROW_ENUM(dem_world_desc, rolling_law, 0, 0, "auto none step constant epsd"),
    DEMI_ROW_CHOICE(tension, "allowed clipped compensated"),
    DEMI_ROW_CHOICE(friction_load, "repulsive elastic magnitude"),
    DEMI_ROW_CHOICE(slider, "parallel spring remainder"),
    DEMI_ROW_CHOICE(convention, "standard mill"), DEMI_ROW_NULL(dem_world_desc, law),
    DEMI_ROW_SAID(law_memory, 'i', DEMI_FROM, DEM_LAW_MEMORY, "law_memory must be 0 to 16 reals"),
    DEMI_ROW_TEXT(dem_world_desc, law_memory_names, DEM_LAW_MEMORY), DEMI_ROW_OF(law_vectors, 'i'),
    DEMI_ROW_SAID(law_stiffness, 'r', DEMI_FROM, DEMI_MOST, "law_stiffness must be 0 to 1e30 N/m; "
                  "0 means the stiffness of the built-in law"),
    DEMI_ROW_SAID(law_range, 'r', DEMI_FROM, DBL_MAX, "law_range (m) must be finite and >= 0; 0 "
                  "calls the law only in contact"),
    DEMI_ROW_SAID(law_range_radii, 'r', DEMI_FROM, DBL_MAX, "law_range_radii must be finite and "
                  ">= 0; 0 calls the law only in contact"),
    DEMI_ROW_OF(law_who, 'i'), DEMI_ROW_NULL(dem_world_desc, law_rate),
    DEMI_ROW_TEXT(dem_world_desc, body_reals, DEM_BODY_REALS),
    DEMI_ROW_TEXT(dem_world_desc, groups, DEM_GROUPS),
    DEMI_ROW_NULL(dem_world_desc, body_reals_fn), DEMI_ROW_NULL(dem_world_desc, growth),
    DEMI_ROW_SAID(growth_interval, 'r', DEMI_FROM, DBL_MAX, "growth_interval (s) must be finite "
                  "and >= 0; 0 changes radii in every step"), DEMI_ROW_NULL(dem_world_desc, force),
    DEMI_ROW_NULL(dem_world_desc, body_force),
    DEMI_ROW_ENUM(dem_world_desc, integrator, 0, 0, "velocity_verlet forward_euler "
                  "symplectic_euler position_verlet leapfrog"), DEMI_ROW_OF(dt, 'r'),
    DEMI_ROW_SAID(impact_speed, 'r', DEMI_FROM, DEMI_FARTHEST, "impact_speed must be 0 to 1e15 "
                  "m/s"), DEMI_ROW_ENUM(dem_world_desc, cone, 0, 0, "coulomb convex"),
    DEMI_ROW_ENUM(dem_world_desc, solver, DEMI_PRINTED, 0, "gauss_seidel jacobi apgd spectral"),
    DEMI_ROW_SAID(sweeps, 'i', DEMI_FROM | DEMI_PRINTED, INT_MAX,
                  "sweeps must be >= 0; 0 means 200"),
    DEMI_ROW_SAID(tolerance, 'r', DEMI_FROM | DEMI_PRINTED, DBL_MAX, "tolerance (m/s) must be "
                  "finite and >= 0; 0 lets the library choose"),
    DEMI_LIMITED(dem_world_desc, cold_start, 'i', DEMI_PRINTED, INT_MAX, ""),
    DEMI_ROW_ENUM(dem_world_desc, search, 0, 0, "auto all_pairs grid linked_list hierarchical "
                  "bins"), DEMI_ROW_SAID(skin, 'r', DEMI_ANY, DBL_MAX, "skin is not finite; 0 lets "
                  "the library choose, below 0 means no skin"),
    DEMI_ROW_CHOICE(rotation, "spiral fincham no_squish"),
    DEMI_ROW_CHOICE(ellipsoid_overlap, "conservative chord normal"),
    DEMI_ROW_CHOICE(cluster_contacts, "merged separate"),
    DEMI_ROW_OF(orientations, 'i'), DEMI_ROW_OF(ledger, 'i'),
    DEMI_ROW_SAID(threads, 'i', DEMI_FROM | DEMI_FREE, 64, "threads must be 0 to 64, where 0 means "
                  "as many as OpenMP offers"), DEMI_ROW_FREE(dem_world_desc, allocator),
    DEMI_ROW_FREE(dem_world_desc, allow_large_dt), DEMI_ROW_FREE(dem_world_desc, unsolved_stops),
    DEMI_ROW_SAID(overlap_stop, 'r', DEMI_FROM | DEMI_FREE, 1, "overlap_stop must be 0 to 1, in "
                  "radii; 0 means off"),
    DEMI_ROW_FREE(dem_world_desc, law_rows), DEMI_ROW_FREE(dem_world_desc, law_user),
    DEMI_ROW_FREE(dem_world_desc, force_user),
    DEMI_ROW_FREE(dem_world_desc, body_reals_user), DEMI_ROW_FREE(dem_world_desc, growth_user),
    DEMI_ROW_END};
