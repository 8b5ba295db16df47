/* Groups (desc.groups) and selections of bodies: who is in, and that membership stays with the body. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

enum { GRAINS = 300 };
static dem_world *crowd(int threads, dem_material *stuff, dem_response response) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    int k;
    desc.domain = box_of(0, 0, 0, 0.06, 0.03, 0.03);
    for (k = 0; k < 3; k++) desc.boundary[k] = k ? DEM_BOUNDARY_OPEN : DEM_BOUNDARY_PERIODIC;
    desc.gravity = at(0, 0, -10);
    desc.threads = threads;
    desc.response = response;
    desc.groups = "coarse tracer left";
    desc.dt = (dem_real)(response == DEM_RESPONSE_IMPULSES ? 2e-4 : 1e-5);
    world = dem_world_create(&desc);
    stuff[0] = scene_material(world, 1e7, 0.5, 0.3, 0);
    stuff[1] = scene_material(world, 1e7, 0.5, 0.3, 0);
    dem_wall_plane_add(world, stuff[0], at(0, 0, 0), at(0, 0, 1));
    dem_wall_plane_add(world, stuff[0], at(0, 0, 0), at(0, 1, 0));
    dem_wall_plane_add(world, stuff[0], at(0, 0.03, 0), at(0, -1, 0));
    CHECK_EQ(dem_spheres_fill(world, stuff[0], DEM_R(1e-3), dem_region_make(box_of(0, 0, 0, 0.06, 0.03, 0.03)),
                              2*GRAINS/3, 1), 2*GRAINS/3);
    CHECK_EQ(dem_spheres_fill(world, stuff[1], DEM_R(1.5e-3), dem_region_make(box_of(0, 0, 0, 0.06, 0.03, 0.03)),
                              GRAINS/3, 2), GRAINS/3);
    return world;
}
/* Marks coarse grains, every seventh grain, and those on the left; returns the ids of the second. */
static void mark(dem_world *world, const dem_material *stuff, dem_body *seventh) {
    dem_selection s = DEM_SELECTION;
    const dem_region left = dem_region_make(box_of(-0.01, 0, 0, 0.02, 0.03, 0.03));
    int k;
    s.material = stuff[1];
    CHECK_EQ(dem_bodies_group_set(world, &s, dem_group_get(world, "coarse"), 1), GRAINS/3);
    s = DEM_SELECTION_ZERO;
    for (k = 0; k < GRAINS/7; k++) seventh[k] = dem_body_id_get(world, 7*k);
    s.count = GRAINS/7;
    s.bodies = seventh;
    CHECK_EQ(dem_bodies_group_set(world, &s, dem_group_get(world, "tracer"), 1), GRAINS/7);
    s = DEM_SELECTION_ZERO;
    s.region = &left;
    CHECK(dem_bodies_group_set(world, &s, dem_group_get(world, "left"), 1) > GRAINS/4);
}
static int count(const dem_world *world, const char *group) {
    dem_selection s = DEM_SELECTION;
    s.group = dem_group_get(world, group);
    return dem_bodies_select(world, &s, 0, 0);
}
/* 1 if the members of "tracer" are these. */
static int same(const dem_world *world, const dem_body *who, int n) {
    dem_selection s = DEM_SELECTION;
    dem_body found[GRAINS];
    int i, k, right = 0;
    s.group = dem_group_get(world, "tracer");
    if (dem_bodies_select(world, &s, found, GRAINS) != n) return 0;
    for (i = 0; i < n; i++)
        for (k = 0; k < n; k++) right += found[i].slot == who[k].slot && found[i].generation == who[k].generation;
    return right == n;
}

static int asked;
static dem_vec3 asks(dem_vec3 x, dem_vec3 v, dem_real r, dem_real m, double time, void *user) {
    dem_selection s = DEM_SELECTION;
    (void)x; (void)v; (void)r; (void)m; (void)time;
    asked = dem_bodies_select(*(dem_world **)user, &s, 0, 0);
    return at(0, 0, 0);
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("members stay members when bodies are sorted, saved, restored, dealt to slabs and collected") {
        const char *const saved = "build/tmp/groups.ckpt";
        dem_material stuff[2];
        dem_body tracer[GRAINS];
        dem_world *world = crowd(1, stuff, DEM_RESPONSE_SPRINGS), *again, *plain;
        dem_slabs_desc deal = DEM_SLABS_DESC;
        dem_slabs *slabs;
        uint64_t hash;
        int left;
        mark(world, stuff, tracer);
        left = count(world, "left");
        CHECK_EQ(dem_world_step(world, 500), DEM_OK);
        CHECK(dem_counters_get(world).rebuilds > 1);
        CHECK(same(world, tracer, GRAINS/7));
        CHECK_EQ(count(world, "coarse"), GRAINS/3);
        CHECK_EQ(count(world, "left"), left);
        CHECK_EQ(dem_checkpoint_write(world, saved), DEM_OK);
        again = crowd(2, stuff, DEM_RESPONSE_SPRINGS);
        CHECK_EQ(dem_checkpoint_read(again, saved), DEM_OK);
        CHECK(same(again, tracer, GRAINS/7));
        hash = dem_world_hash_get(world);
        CHECK(dem_world_hash_get(again) == hash);
        deal.count = 3;
        slabs = dem_slabs_create(again, &deal);
        CHECK(slabs != 0);
        CHECK_EQ(dem_slabs_step(slabs, 300), DEM_OK);
        CHECK_EQ(dem_slabs_collect(slabs, again), DEM_OK);
        dem_slabs_destroy(slabs);
        CHECK(same(again, tracer, GRAINS/7));
        CHECK_EQ(count(again, "coarse"), GRAINS/3);
        CHECK_EQ(count(again, "left"), left);
        /* a world without groups moves alike */
        plain = crowd(1, stuff, DEM_RESPONSE_SPRINGS);
        CHECK_EQ(dem_world_step(plain, 500), DEM_OK);
        CHECK(!memcmp(dem_bodies_get(plain).positions, dem_bodies_get(world).positions, 4*GRAINS*sizeof(dem_real)));
        dem_world_destroy(plain);
        dem_world_destroy(again);
        dem_world_destroy(world);
        remove(saved);
    }
    TEST("the bodies of a region are removed in one call, and their ids and memberships end") {
        int response;
        for (response = 0; response < 2; response++) {
            const dem_region middle = dem_region_make(box_of(0.02, 0, 0, 0.04, 0.03, 0.03));
            dem_material stuff[2];
            dem_body tracer[GRAINS], gone[GRAINS], after;
            dem_body_state state;
            dem_selection s = DEM_SELECTION;
            dem_world *world = crowd(1, stuff, response ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS);
            int n, k, still = 0;
            mark(world, stuff, tracer);
            CHECK_EQ(dem_world_step(world, 30), DEM_OK);
            s.region = &middle;
            n = dem_bodies_select(world, &s, gone, GRAINS);
            CHECK(n > GRAINS/6);
            CHECK_EQ(dem_bodies_remove(world, &s), n);
            CHECK_EQ(dem_bodies_select(world, &s, 0, 0), 0);
            CHECK_EQ(dem_bodies_remove(world, &s), 0);
            CHECK_EQ(dem_body_counts_get(world).present, GRAINS - n);
            CHECK_EQ(dem_body_counts_get(world).removed, n);
            for (k = 0; k < n; k++) CHECK_EQ(dem_body_get(world, gone[k], &state), DEM_ERROR_ARGUMENT);
            for (k = 0; k < GRAINS/7; k++) still += dem_body_get(world, tracer[k], &state) == DEM_OK;
            CHECK_EQ(count(world, "tracer"), still);
            CHECK_EQ(dem_world_step(world, 30), DEM_OK);
            /* a new body takes the slot of an old one, not its groups */
            after = dem_sphere_add(world, stuff[0], DEM_R(1e-3), at(0.03, 0.015, 0.02));
            CHECK_EQ(count(world, "tracer"), still);
            s = DEM_SELECTION_ZERO;
            s.bodies = &after;
            s.count = 1;
            CHECK_EQ(dem_bodies_group_set(world, &s, dem_group_get(world, "tracer"), 1), 1);
            CHECK_EQ(count(world, "tracer"), still + 1);
            CHECK_EQ(dem_bodies_group_set(world, &s, dem_group_get(world, "tracer"), 0), 1);
            CHECK_EQ(count(world, "tracer"), still);
            s.bodies = gone;
            s.count = n;
            CHECK_EQ(dem_bodies_select(world, &s, 0, 0), 0);
            dem_world_destroy(world);
        }
    }
    TEST("groups are set in motion, frozen, averaged, sampled by fields and written to files") {
        const char *const path = "build/tmp/groups.vtp", *const film = "build/tmp/groups.html";
        dem_material stuff[2];
        dem_body tracer[GRAINS];
        dem_world *world = crowd(1, stuff, DEM_RESPONSE_SPRINGS);
        dem_selection s = DEM_SELECTION;
        dem_bodies_means m, all;
        dem_field_desc field = DEM_FIELD_DESC;
        dem_field_data data;
        dem_replay_desc replay = DEM_REPLAY_DESC;
        dem_replay *r;
        dem_field f;
        char *text;
        FILE *file;
        size_t n;
        int k;
        mark(world, stuff, tracer);
        s.group = dem_group_get(world, "coarse");
        CHECK_EQ(dem_bodies_velocity_set(world, &s, at(0.1, 0, 0.2), at(0, 3, 0)), GRAINS/3);
        CHECK_EQ(dem_bodies_means_get(world, &s, &m), DEM_OK);
        CHECK_EQ(m.bodies, GRAINS/3);
        CHECK_REL(m.mass, 2500*4/3.0*3.14159265358979*3.375e-9*m.bodies, 1e-6);
        CHECK_NEAR(m.velocity[0], 0.1, 1e-7);
        CHECK_NEAR(m.spin[1], 3, 1e-6);
        CHECK_NEAR(m.radius, 1.5e-3, 1e-9);
        CHECK_REL(m.kinetic, m.mass*0.05/2, 1e-6);
        s.group.id = 0;
        CHECK_EQ(dem_bodies_means_get(world, &s, &all), DEM_OK);
        CHECK_REL(all.mass, dem_totals_get(world).mass, 1e-12);
        CHECK_REL(all.kinetic, m.kinetic, 1e-6);            /* the others are at rest */
        field.box = box_of(0, 0, 0, 0.06, 0.03, 0.03);
        field.cells[0] = field.cells[1] = field.cells[2] = 1;
        field.group = dem_group_get(world, "tracer");
        field.interval = 1e-9;
        f = dem_field_add(world, &field);
        s.group = dem_group_get(world, "tracer");
        CHECK_EQ(dem_bodies_fixed_set(world, &s, 1), GRAINS/7);
        replay.number = "tracer";
        r = dem_replay_open(world, film, &replay);
        CHECK(r != 0);
        CHECK_EQ(dem_world_step(world, 20), DEM_OK);
        CHECK_EQ(dem_bodies_means_get(world, &s, &m), DEM_OK);
        CHECK_NEAR(m.velocity[2], 0, 0);
        CHECK_EQ(dem_field_get(world, f, &data), DEM_OK);
        CHECK_NEAR(data.grains[0]/(double)data.samples, GRAINS/7, 1e-9);
        CHECK_EQ(dem_bodies_fixed_set(world, &s, 0), GRAINS/7);
        CHECK_EQ(dem_world_step(world, 20), DEM_OK);
        CHECK_EQ(dem_bodies_means_get(world, &s, &m), DEM_OK);
        CHECK(m.velocity[2] < -1e-4);                       /* free again */
        CHECK_EQ(dem_replay_frame_write(r), DEM_OK);
        CHECK_EQ(dem_replay_close(r), DEM_OK);
        CHECK_EQ(dem_vtp_write(world, path), DEM_OK);
        file = fopen(path, "rb");
        text = (char *)calloc(1, 20000);
        n = file ? fread(text, 1, 19999, file) : 0;
        for (k = 0; k < (int)n; k++) if (!text[k]) text[k] = ' ';
        CHECK_STR(text, "\"groups\"");
        if (file) fclose(file);
        file = fopen(film, "rb");
        CHECK(file != 0);
        if (file) fclose(file);
        free(text);
        remove(path);
        remove(film);
        dem_world_destroy(world);
    }
    TEST("a selection finds bodies by size, shape, list and region at once, also across a periodic face") {
        dem_material stuff[2];
        dem_world *world = crowd(1, stuff, DEM_RESPONSE_SPRINGS);
        dem_region across = dem_region_make(box_of(0.05, 0, 0, 0.07, 0.03, 0.03));
        dem_selection s = DEM_SELECTION;
        const dem_bodies b = dem_bodies_get(world);
        int k, n = 0, big = 0;
        for (k = 0; k < b.count; k++) {
            const double x = (double)b.positions[4*k];
            n += x >= 0.05 || x <= 0.01;
            big += (x >= 0.05 || x <= 0.01) && (double)b.positions[4*k + 3] > 1.2e-3;
        }
        s.region = &across;
        CHECK_EQ(dem_bodies_select(world, &s, 0, 0), n);
        s.radius_min = DEM_R(1.2e-3);
        CHECK_EQ(dem_bodies_select(world, &s, 0, 0), big);
        s.material = stuff[0];
        CHECK_EQ(dem_bodies_select(world, &s, 0, 0), 0);
        s = DEM_SELECTION_ZERO;
        s.shape = dem_shape_ellipsoid_add(world, at(1e-3, 1e-3, 2e-3));
        CHECK_EQ(dem_bodies_select(world, &s, 0, 0), 0);
        CHECK(dem_body_add(world, stuff[0], s.shape, at(0.03, 0.015, 0.05), dem_quat_make(1, 0, 0, 0)).slot > 0);
        CHECK_EQ(dem_bodies_select(world, &s, 0, 0), 1);
        dem_world_destroy(world);
    }
    TEST("groups that desc.groups does not name are errors that name it") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_selection s = DEM_SELECTION;
        dem_world *world;
        dem_group group;
        desc.groups = "one two";
        world = dem_world_create(&desc);
        group = dem_group_get(world, "three");
        CHECK_EQ(group.id, 0);
        CHECK_STR(dem_world_error_get(world), "there is no group \"three\"; desc.groups names \"one two\"");
        CHECK_EQ(dem_group_get(world, "two").id, 2);
        CHECK_EQ(dem_bodies_group_set(world, &s, group, 1), -1);
        CHECK_STR(dem_world_error_get(world), "group 0 does not exist");
        s.group.id = 3;
        CHECK_EQ(dem_bodies_remove(world, &s), -1);
        s.group.id = 0;
        s.count = 1;
        CHECK_EQ(dem_bodies_select(world, &s, 0, 0), -1);
        s.count = 0;
        dem_world_destroy(world);
        desc.force = asks;
        desc.force_user = &world;
        desc.threads = 1;
        world = dem_world_create(&desc);
        dem_sphere_add(world, scene_material(world, 1e7, 0.5, 0, 0), DEM_R(1e-3), at(0, 0, 0));
        CHECK_EQ(dem_world_step(world, 2), DEM_OK);
        CHECK_EQ(asked, -1);
        CHECK_STR(dem_world_error_get(world), "dem_bodies_select: called from a function that dem_world_step calls");
        CHECK_EQ(dem_bodies_select(world, &s, 0, 0), 1);
        dem_world_destroy(world);
        desc.groups = "a-b";
        CHECK(dem_world_create(&desc) == 0);
        CHECK_STR(dem_world_create_error_get(&desc), "groups must be at most 32 words");
    }
    return test_end();
}
