/* Rows of fields (src/core/rows.h): every field of a struct has one, and its limits are those of the call. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../walk.h"

/* Bytes of its struct that a row stands for. */
static size_t row_bytes(const demi_field_row *r) {
    return r->type == 'h' ? 0 : (r->type == 'p' || r->type == 't') && !(r->how & DEMI_FREE) ? sizeof(void (*)(void)) : r->size;
}
static const demi_field_row *row_at(const demi_field_row *r, size_t offset) {
    for (; r->name; r++) if (offset >= r->offset && offset < r->offset + row_bytes(r)) return r;
    return 0;
}
/* Every field of a struct, which begins at `start`, has a row, except `without` of them; else names those that have none. */
static void rows_cover(const char *text, const char *type, size_t size, const demi_field_row *rows, size_t start, int without) {
    static walk_fields all;
    size_t align;
    int k, missing = 0;
    memset(&all, 0, sizeof all);
    CHECK_EQ(walk_struct(text, type, "", start, &align, &all), size);
    CHECK_EQ(all.wrong, 0);
    CHECK(all.count > 0);
    for (k = 0; k < all.count; k++)
        if (!row_at(rows, all.field[k].offset) && ++missing > without) printf("        %s.%s has no row\n", type, all.field[k].name);
    CHECK_EQ(missing, without);
}
#define ALL_ROWS(type, rows) rows_cover(text, #type, sizeof(type), rows, 0, 0)
#define PART_ROWS(type, rows, part) rows_cover(text, #type, sizeof(type), rows, offsetof(dem_world, part), 0)

/* A desc with one bad value goes to its call; the message has the name of the field. */
enum { ROWS_WORLD, ROWS_MATERIAL, ROWS_PAIR, ROWS_SIEVE, ROWS_FEED, ROWS_OUTLET, ROWS_MOTION, ROWS_FIELD, ROWS_JOINT,
       ROWS_TRIALS, ROWS_REPLAY, ROWS_DESCS };
static void row_spoil(const demi_field_row *r, void *item, int k, double x) {
    char *at = (char *)item + r->offset + (size_t)k*demi_row_item(r);
    const int32_t i = fabs(x) < INT32_MAX ? (int32_t)x : 0;
    const dem_real y = (dem_real)x;
    if (r->type == 'i' || r->type == 'e') memcpy(at, &i, sizeof i);
    else if (r->type == 'd') memcpy(at, &x, sizeof x);
    else memcpy(at, &y, sizeof y);
}
static int row_refused(int desc, const demi_field_row *r, int k, double x) {
    walk_scene s = walk_begin(desc == ROWS_JOINT ? WALK_IMPULSES : WALK_SPRINGS);
    static dem_trials trials;
    dem_trials_desc plan = DEM_TRIALS_DESC;
    dem_replay_desc replay = DEM_REPLAY_DESC;
    dem_world *world = dem_world_create(&s.world);
    dem_material m;
    demi_wall wall;
    void *const items[ROWS_DESCS] = {&s.world, &s.material, &s.pair, &wall, &s.feed, &s.outlet, &s.motion,
        &s.field, &s.joint, &plan, &replay};
    const char *error;
    int good = 0;
    m = dem_material_add(world, &s.material);
    wall.sieve = s.sieve;
    plan.duration = 1;
    row_spoil(r, items[desc], k, x);
    if (desc == ROWS_WORLD) error = dem_world_create_error_get(&s.world);
    else {
        if (desc == ROWS_MATERIAL) good = dem_material_add(world, &s.material).id;
        if (desc == ROWS_PAIR) good = dem_pair_set(world, m, m, &s.pair) == DEM_OK;
        if (desc == ROWS_SIEVE) good = dem_wall_sieve_add(world, m, &wall.sieve).id;
        if (desc == ROWS_FEED) good = dem_feed_add(world, &s.feed).id;
        if (desc == ROWS_OUTLET) good = dem_outlet_add(world, &s.outlet).id;
        if (desc == ROWS_MOTION)
            good = dem_wall_motion_set(world, dem_wall_plane_add(world, m, s.plane_point, s.plane_normal), &s.motion) == DEM_OK;
        if (desc == ROWS_FIELD) good = dem_field_add(world, &s.field).id;
        if (desc == ROWS_JOINT) good = dem_joint_add(world, &s.joint).id;
        if (desc == ROWS_TRIALS) good = dem_trials_run(world, &plan, &trials) == DEM_OK;
        if (desc == ROWS_REPLAY) good = dem_replay_open(world, "build/tmp/rows.html", &replay) != 0;
        error = dem_world_error_get(world);
    }
    good = !good && (desc == ROWS_WORLD ? !strcmp(error, r->refusal) : strstr(error, r->name) && strstr(error, ", must be "));
    if (!good) printf("        %s = %g: \"%s\"\n", r->name, x, error);
    dem_world_destroy(world);
    return good;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("every field of every desc and of every number that slabs exchange has a row") {
        char *text = walk_text();
        const demi_field_row *r;
        size_t bytes = 0;
        ALL_ROWS(dem_world_desc, demi_world_desc_rows);
        ALL_ROWS(dem_material_desc, demi_material_rows);
        ALL_ROWS(dem_pair, demi_pair_rows);
        ALL_ROWS(dem_field_desc, demi_field_rows);
        ALL_ROWS(dem_cell_desc, demi_cell_rows);
        PART_ROWS(demi_strained, demi_number_rows, cell);
        ALL_ROWS(dem_feed_desc, demi_feed_rows);
        ALL_ROWS(dem_outlet_desc, demi_outlet_rows);
        ALL_ROWS(dem_motion, demi_motion_rows);
        ALL_ROWS(dem_joint_desc, demi_joint_fields);
        ALL_ROWS(dem_trials_desc, demi_trials_rows);
        ALL_ROWS(dem_replay_desc, demi_replay_rows);
        ALL_ROWS(dem_wall_loads, demi_loads_rows);
        ALL_ROWS(dem_outlet_state, demi_outlet_state_rows);
        PART_ROWS(demi_timing, demi_number_rows, clock);
        PART_ROWS(demi_stages, demi_number_rows, stage);
        PART_ROWS(demi_margin, demi_number_rows, margin);
        PART_ROWS(dem_body_counts, demi_number_rows, bodies.balance);
        /* point, normal and along of a sieve are in the wall's pose */
        rows_cover(text, "dem_sieve_desc", sizeof(dem_sieve_desc), demi_wall_rows, offsetof(demi_wall, sieve), 9);
        for (r = demi_booked_rows; r->name; r++) bytes += r->size;
        CHECK_EQ(bytes, sizeof(demi_booked));   /* it has no padding */
        CHECK_EQ(offsetof(demi_feed, desc), 0);
        CHECK_EQ(offsetof(demi_outlet, desc), 0);
        free(text);
    }
    TEST("each call refuses a value beyond the limit in the field's row, NaN and infinity, and names the field") {
        static const demi_field_row *const tables[ROWS_DESCS] = {demi_world_desc_rows, demi_material_rows, demi_pair_rows,
            demi_wall_rows, demi_feed_rows, demi_outlet_rows, demi_motion_rows, demi_field_rows, demi_joint_fields,
            demi_trials_rows, demi_replay_rows};
        int desc, k, tried = 0;
        for (desc = 0; desc < ROWS_DESCS; desc++) {
            const demi_field_row *r;
            for (r = tables[desc]; r->name; r++)
                for (k = 0; r->how & DEMI_LIMITS && k < (int)(r->size/demi_row_item(r)); k++) {
                    const int whole = r->type == 'i' || r->type == 'e';
                    const double most = demi_row_most(r), above = whole ? most + 1 : r->how & DEMI_UNDER ? most : 1.1*most;
                    if (!(r->how & DEMI_ANY)) CHECK(row_refused(desc, r, k, -1));
                    if (r->how & DEMI_OVER && !r->other) CHECK(row_refused(desc, r, k, 0));
                    if (whole ? most < INT_MAX : most < 1e300) CHECK(row_refused(desc, r, k, above));
                    if (!whole) CHECK(row_refused(desc, r, k, NAN));
                    if (!whole) CHECK(row_refused(desc, r, k, INFINITY));
                    tried++;
                }
        }
        CHECK(tried > 100);
    }
    TEST("what slabs add up: sums, the largest and bits of every field that is declared so, other fields stay") {
        dem_outlet_state sum, part, before;
        const demi_field_row *r;
        size_t k;
        unsigned char *const a = (unsigned char *)&sum, *const b = (unsigned char *)&part;
        memset(&sum, 0, sizeof sum);
        memset(&part, 0, sizeof part);
        for (r = demi_outlet_state_rows; r->name; r++)
            for (k = 0; k < r->size/8; k++) {
                const uint64_t u = 3 + r->offset + k;
                const double x = (double)u + 0.5;
                memcpy(a + r->offset + 8*k, r->type == 'u' ? (const void *)&u : (const void *)&x, 8);
                memcpy(b + r->offset + 8*k, r->type == 'u' ? (const void *)&u : (const void *)&x, 8);
            }
        part.last = 1e9;
        before = sum;
        demi_rows_add(demi_outlet_state_rows, &sum, &part);
        for (k = 0; k < 16; k++) {
            CHECK_EQ(sum.count[k], 2*before.count[k]);
            CHECK_EQ(sum.back[k], 2*before.back[k]);
            CHECK_NEAR(sum.mass[k], 2*before.mass[k], 0);
            CHECK_NEAR(sum.back_mass[k], 2*before.back_mass[k], 0);
        }
        CHECK_EQ(sum.sorted + sum.gangue + sum.total, 2*(before.sorted + before.gangue + before.total));
        CHECK_NEAR(sum.last, 1e9, 0);
        CHECK_NEAR(sum.since, before.since, 0);
    }
    return test_end();
}
