/* Uses what docs/extending*.md add to dem.h. tests/recipes.sh builds it with the patched header first on the include
   path. A law or integrator of a recipe must do what its page says, and must work with spheres, ellipsoids, clusters,
   meshes, threads, checkpoint and report without further edits. */
#define DEM_IMPLEMENTATION
#include <dem.h>
#include "test.h"
#include "scene.h"

/* s: dissipation_time, a coefficient that the viscoelastic law alone has */
static dem_real mixture_time = DEM_R(1e-5);
/* Spheres of two sizes, ellipsoids and a cluster that fall on a mesh and on each other. */
static dem_world *mixture(dem_world_desc desc, int threads) {
    static const dem_real places[6] = {DEM_R(-0.004), 0, 0, DEM_R(0.004), 0, 0};
    static const dem_real radii[2] = {DEM_R(0.005), DEM_R(0.004)};
    dem_cluster_desc cluster = DEM_CLUSTER_DESC;
    dem_world *world;
    dem_material m;
    dem_pair pair;
    dem_shape shape[2];
    int i;
    desc.gravity.z = DEM_R(-9.81);
    desc.threads = threads;
    desc.impact_speed = 1;
    world = dem_world_create(&desc);
    m = scene_material(world, 1e6, 0.8, 0.4, 0.05);
    dem_pair_get(world, m, m, &pair);
    pair.dissipation_time = mixture_time;
    dem_pair_set(world, m, m, &pair);
    cluster.count = 2;
    cluster.positions = places;
    cluster.radii = radii;
    shape[0] = dem_shape_ellipsoid_add(world, at(0.004, 0.005, 0.006));
    shape[1] = dem_shape_cluster_add(world, &cluster);
    scene_floor(world, m, -0.1, -0.1, 0.1, 0.1, 3, 3);
    for (i = 0; i < 27; i++) {
        const dem_vec3 x = at(0.013*(i%3), 0.013*(i/3%3), 0.008 + 0.013*(i/9));
        if (i%3) dem_body_add(world, m, shape[i%3 - 1], x, dem_quat_make(1, DEM_R(0.3)*(dem_real)i, 0, 1));
        else dem_sphere_add(world, m, DEM_R(0.004) + DEM_R(0.0001)*(dem_real)i, x);
    }
    return world;
}
/* The same bits by 1 and 2 threads and after a checkpoint; reports call it by its name. */
static void serves(dem_world_desc desc, const char *name) {
    const char *path = "build/recipes/state.ckpt";
    dem_world *a = mixture(desc, 1), *b = mixture(desc, 2), *c = mixture(desc, 1);
    FILE *file = fopen("build/recipes/report.txt", "w+");
    static char text[20000];
    int walls = 0, pairs = 0, k;
    for (k = 0; k < 20; k++) {
        CHECK_EQ(scene_step(a, 100), DEM_OK);
        walls |= dem_counters_get(a).wall_contacts;
        pairs |= dem_counters_get(a).contacts;
    }
    CHECK(walls && pairs);
    CHECK_EQ(scene_step(b, 1000), DEM_OK);
    CHECK_EQ(dem_checkpoint_write(b, path), DEM_OK);
    CHECK_EQ(scene_step(b, 1000), DEM_OK);
    CHECK_EQ(dem_checkpoint_read(c, path), DEM_OK);
    CHECK_EQ(scene_step(c, 1000), DEM_OK);
    CHECK(dem_world_hash_get(a) == dem_world_hash_get(b));
    CHECK(dem_world_hash_get(a) == dem_world_hash_get(c));
    CHECK(file != 0);
    if (file) {
        dem_world_report(a, file);
        rewind(file);
        text[fread(text, 1, sizeof text - 1, file)] = 0;
        fclose(file);
        CHECK_STR(text, name);
    }
    remove(path);
    dem_world_destroy(a);
    dem_world_destroy(b);
    dem_world_destroy(c);
}
static const char *text_of(const char *path) {
    static char text[400000];
    FILE *file = fopen(path, "rb");
    text[0] = 0;
    CHECK(file != 0);
    if (file) text[fread(text, 1, sizeof text - 1, file)] = 0;
    if (file) fclose(file);
    remove(path);
    return text;
}
/* The same scene, or with other = 1 one whose addition has another value, passes every list that a scene passes: digest,
   checkpoint, refusal of the checkpoint of the other scene, report, slabs. Words: of the refusal, of the report. */
static void in_every_list(dem_world *(*scene)(int other), const char *refusal, const char *report, int slabs) {
    const char *path = "build/recipes/list.ckpt";
    dem_world *a = scene(0), *b = scene(0), *c = scene(1), *d = scene(0);
    dem_slabs_desc deal = DEM_SLABS_DESC;
    int k;
    CHECK(demi_scene_digest(a) == demi_scene_digest(b));
    CHECK(demi_scene_digest(a) != demi_scene_digest(c));
    CHECK_EQ(scene_step(a, 300), DEM_OK);
    CHECK_EQ(dem_checkpoint_write(a, path), DEM_OK);
    CHECK_EQ(dem_checkpoint_read(b, path), DEM_OK);
    CHECK_EQ(dem_checkpoint_read(c, path), DEM_ERROR_FORMAT);
    CHECK_STR(dem_world_error_get(c), refusal);
    CHECK_EQ(scene_step(a, 100), DEM_OK);
    CHECK_EQ(scene_step(b, 100), DEM_OK);
    CHECK(dem_world_hash_get(a) == dem_world_hash_get(b));
    scene_report_has(a, report);
    for (k = 1; k <= 2 && slabs; k++) {        /* one slab: the bits of a world; two: round-off */
        dem_slabs *s;
        deal.count = k;
        if (k == 2) {
            dem_world_destroy(d);
            d = scene(0);
        }
        s = dem_slabs_create(d, &deal);
        CHECK(s != 0);
        if (!s) { puts(dem_world_error_get(d)); break; }
        CHECK_EQ(dem_slabs_step(s, 400), DEM_OK);
        CHECK_EQ(dem_slabs_collect(s, d), DEM_OK);
        dem_slabs_destroy(s);
        if (k == 1) {                         /* contact memory in a list, on both sides */
            dem_candidates_rebuild(a);
            dem_candidates_rebuild(d);
            CHECK(dem_world_hash_get(a) == dem_world_hash_get(d));
        }
        else {
            const double gone = demi_length(demi_sub(scene_state(a, dem_body_id_get(a, 0)).position,
                scene_state(d, dem_body_id_get(a, 0)).position));
            CHECK_NEAR(gone, 0, 1e-7);
        }
    }
    remove(path);
    dem_world_destroy(a);
    dem_world_destroy(b);
    dem_world_destroy(c);
    dem_world_destroy(d);
}
/* What a replay of one frame has. */
static void replay_has(dem_world *world, const char *words) {
    const char *path = "build/recipes/frame.html";
    dem_replay *replay = dem_replay_open(world, path, 0);
    CHECK(replay != 0);
    CHECK_EQ(dem_replay_frame_write(replay), DEM_OK);
    CHECK_EQ(dem_replay_close(replay), DEM_OK);
    CHECK(strstr(text_of(path), words) != 0);
}
/* Restitution of a ball that meets a plane at a speed. */
static double bounce(dem_world_desc desc, double speed) {
    dem_world *world;
    dem_material m;
    dem_pair pair;
    dem_body ball;
    double e;
    desc.impact_speed = (dem_real)speed;
    desc.dt = 0;
    world = dem_world_create(&desc);
    m = scene_material(world, 1e7, 0.9, 0, 0);
    dem_pair_get(world, m, m, &pair);
    pair.dissipation_time = DEM_R(1e-5);
    dem_pair_set(world, m, m, &pair);
    dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
    ball = dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, 0.01));
    scene_move(world, ball, at(0, 0, -speed), at(0, 0, 0));
    scene_step(world, 400);
    e = (double)scene_state(world, ball).velocity.z/speed;
    dem_world_destroy(world);
    return e;
}

/* Fifty pairs of spheres of fifty radii and two materials that approach: each force is that of the closed form. */
static void closed_forms(void) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material_desc stuff = scene_stuff(1e7, 0.9, 0, 0);
    dem_material m[2];
    dem_contact_info found[60];
    dem_pair pair;
    int i, n;
    desc.normal_law = DEM_NORMAL_VISCOELASTIC;
    desc.dt = DEM_R(1e-9);
    world = dem_world_create(&desc);
    for (i = 0; i < 2; i++) {
        stuff.dissipation_time = DEM_R(1e-5)*(i ? 4 : 1);
        m[i] = dem_material_add(world, &stuff);
    }
    dem_pair_get(world, m[0], m[1], &pair);
    CHECK_REL(pair.dissipation_time, 2e-5, 1e-6);           /* the geometric mean */
    for (i = 0; i < 100; i++) {
        const double r = 0.01 + 1e-5*(i/2);
        const dem_body ball = dem_sphere_add(world, m[i%4 == 3], (dem_real)r, at(i%2 ? 1.99*r : 0, 0.05*(i/2), 0));
        scene_move(world, ball, at(i%2 ? -1 : 1, 0, 0), at(0, 0, 0));
    }
    CHECK_EQ(scene_step(world, 1), DEM_OK);
    CHECK(demi_many_species(world));
    n = dem_contacts_get(world, found, 60);
    CHECK_EQ(n, 50);
    for (i = 0; i < n; i++) {
        const double d = found[i].overlap, r = scene_state(world, found[i].a).radius;
        const dem_body_state b = scene_state(world, found[i].b);
        dem_coefficients k;
        dem_coefficients_get(world, m[0], b.material, (dem_real)r, (dem_real)r, &k);
        CHECK_REL(k.ca, 1.5*k.kn*(b.material.id == 2 ? 2e-5 : 1e-5), 1e-6);
        CHECK_REL(-found[i].force.x, k.kn*d*sqrt(d) + k.ca*sqrt(d)*2, 1e-4);
    }
    stuff.dissipation_time = -1;
    CHECK_EQ(dem_material_add(world, &stuff).id, 0);
    CHECK_STR(dem_world_error_get(world), "dissipation_time is -1 s, must be >= 0 s");
    dem_world_destroy(world);
}
static dem_world *viscoelastic(int other) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    desc.normal_law = DEM_NORMAL_VISCOELASTIC;
    mixture_time = other ? DEM_R(2e-5) : DEM_R(1e-5);
    world = mixture(desc, 1);
    mixture_time = DEM_R(1e-5);
    return world;
}
/* A ball and a cluster that fall into a shell. */
static dem_world *shell(int other) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material m;
    desc.gravity.z = DEM_R(-9.81);
    world = dem_world_create(&desc);
    m = scene_material(world, 1e6, 0.5, 0.5, 0);
    dem_wall_shell_add(world, m, at(0.1, 0, 1), other ? DEM_R(0.06) : DEM_R(0.05));
    dem_sphere_add(world, m, DEM_R(0.01), at(0.08, 0, 0.97));
    dem_sphere_add(world, m, DEM_R(0.01), at(0.12, 0.01, 0.97));
    return world;
}
/* Files draw the shell as a sphere of triangles. */
static void shell_drawn(void) {
    dem_world *world = shell(0);
    const char *path = "build/recipes/shell.vtp";
    char points[64];
    int64_t count = 0, triangles = 0;
    dem_real z[2] = {0, 0}, *place;
    int32_t *corners, *id;
    int i;
    demi_wall_draw(world, 0, z, &count, &triangles, 0, 0, 0);
    CHECK(count > 200 && triangles > 400);
    place = (dem_real *)calloc((size_t)count, 3*sizeof *place);
    corners = (int32_t *)calloc((size_t)triangles, 3*sizeof *corners);
    id = (int32_t *)calloc((size_t)triangles, sizeof *id);
    snprintf(points, sizeof points, "NumberOfPoints=\"%d\"", (int)count);
    count = triangles = 0;
    demi_wall_draw(world, 0, z, &count, &triangles, place, corners, id);
    for (i = 0; i < count; i++)
        CHECK_REL(demi_length(demi_sub(demi_at(place + 3*i), at(0.1, 0, 1))), 0.05, 1e-6);
    CHECK_EQ(dem_walls_vtp_write(world, path, 0, 0), DEM_OK);
    CHECK_STR(text_of(path), points);
    replay_has(world, "\"kind\":\"mesh\",\"radius\":0.05");
    free(place);
    free(corners);
    free(id);
    dem_world_destroy(world);
}
static double energy_of_motion(const dem_world *world) {
    const dem_totals sum = dem_totals_get(world);
    return sum.kinetic + sum.rotational;
}
/* Frictionless, without loss: a capsule thrown askew onto a plane and, in mid-air, two at each other, one of them against
   a ball. */
static void rods_bounce(void) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material m;
    dem_shape rod;
    dem_body body[4];
    double start, turning, hits = 0;
    int i;
    desc.dt = DEM_R(1e-6);
    world = dem_world_create(&desc);
    m = scene_material(world, 1e7, 1, 0, 0);
    rod = dem_shape_capsule_add(world, DEM_R(0.01), DEM_R(0.004));
    CHECK(rod.id == 1);
    dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
    dem_wall_plane_add(world, m, at(0, 0, 0.06), at(0, 0, -1));
    body[0] = dem_body_add(world, m, rod, at(0, 0, 0.03), dem_quat_make(1, DEM_R(0.3), DEM_R(0.2), 0));
    body[1] = dem_body_add(world, m, rod, at(1, 0, 0.03), dem_quat_make(1, 0, 0, 0));
    body[2] = dem_body_add(world, m, rod, at(1.03, 0.007, 0.028), dem_quat_make(1, 1, DEM_R(0.2), 0));
    body[3] = dem_sphere_add(world, m, DEM_R(0.006), at(1.06, 0.003, 0.034));
    scene_move(world, body[0], at(0, 0, -1), at(0, 0, 0));
    scene_move(world, body[2], at(-1, 0, 0), at(0, 0, 0));
    scene_move(world, body[3], at(-1.5, 0, 0), at(0, 0, 0));
    start = energy_of_motion(world);
    for (i = 0; i < 4000; i++) {
        CHECK_EQ(scene_step(world, 100), DEM_OK);
        hits += dem_counters_get(world).contacts + dem_counters_get(world).wall_contacts;
    }
    CHECK(hits > 20);
    CHECK(dem_counters_get(world).contacts + dem_counters_get(world).wall_contacts == 0);
    CHECK_REL(energy_of_motion(world), start, 1e-4);
    for (turning = 0, i = 0; i < 3; i++)
        turning += (double)demi_dot(scene_state(world, body[i]).spin, scene_state(world, body[i]).spin);
    CHECK(turning > 100);
    dem_world_destroy(world);
}
/* Volume and moments beside those of 201 balls in a row, matter counted once. */
static void rods_weigh(void) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world = dem_world_create(&desc);
    dem_cluster_desc row = DEM_CLUSTER_DESC;
    static dem_real places[3*201];
    dem_shape_info rod, balls;
    int i;
    for (i = 0; i < 201; i++) places[3*i + 2] = DEM_R(1e-4)*(dem_real)(i - 100);
    row.count = 201;
    row.positions = places;
    row.radius = DEM_R(0.004);
    CHECK_EQ(dem_shape_get(world, dem_shape_capsule_add(world, DEM_R(0.01), DEM_R(0.004)), &rod), DEM_OK);
    CHECK_EQ(dem_shape_get(world, dem_shape_cluster_add(world, &row), &balls), DEM_OK);
    CHECK_REL(rod.volume, balls.volume, 2e-4);
    CHECK_REL(rod.inertia.x, balls.inertia.x, 2e-4);
    CHECK_REL(rod.inertia.z, balls.inertia.z, 2e-4);
    CHECK_REL(rod.radius, 0.014, 1e-12);
    dem_world_destroy(world);
}
/* A heap of capsules, balls and clusters between four planes: the same bits by 1 and 2 threads and on from a checkpoint. */
static void rods_rest(void) {
    static const dem_real places[6] = {DEM_R(-0.004), 0, 0, DEM_R(0.004), 0, 0};
    const char *path = "build/recipes/rods.ckpt";
    uint64_t hash[3] = {0, 0, 0};
    int run, i;
    for (run = 0; run < 3; run++) {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_cluster_desc two = DEM_CLUSTER_DESC;
        dem_world *world;
        dem_material m;
        dem_shape shape[2];
        desc.gravity.z = DEM_R(-9.81);
        desc.threads = 1 + (run == 1);
        world = dem_world_create(&desc);
        m = scene_material(world, 1e6, 0.3, 0.5, 0.1);
        two.count = 2;
        two.positions = places;
        two.radius = DEM_R(0.005);
        shape[0] = dem_shape_capsule_add(world, DEM_R(0.006), DEM_R(0.004));
        shape[1] = dem_shape_cluster_add(world, &two);
        dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        for (i = 0; i < 4; i++)
            dem_wall_plane_add(world, m, at(i == 0 ? -0.02 : i == 1 ? 0.06 : 0, i == 2 ? -0.02 : i == 3 ? 0.06 : 0, 0),
                          at(i == 0 ? 1 : i == 1 ? -1 : 0, i == 2 ? 1 : i == 3 ? -1 : 0, 0));
        for (i = 0; i < 36; i++) {
            const dem_vec3 x = at(0.02*(i%3), 0.02*(i/3%3), 0.012 + 0.02*(i/9));
            if (i%3) dem_body_add(world, m, shape[i%3 - 1], x, dem_quat_make(1, DEM_R(0.3)*(dem_real)i, DEM_R(0.2), 1));
            else dem_sphere_add(world, m, DEM_R(0.005), x);
        }
        if (run < 2) CHECK_EQ(dem_world_run(world, 0.1, 0, 0), DEM_OK);
        if (run == 1) CHECK_EQ(dem_checkpoint_write(world, path), DEM_OK);
        if (run == 2) CHECK_EQ(dem_checkpoint_read(world, path), DEM_OK);
        CHECK_EQ(dem_world_run(world, 0.9, 0, 0), DEM_OK);
        hash[run] = dem_world_hash_get(world);
        CHECK(dem_counters_get(world).contacts > 20);
        CHECK(energy_of_motion(world) < 1e-5);    /* it fell by some 2e-2 J */
        for (i = 0; i < 36; i++) CHECK(demi_at(world->bodies.pos + 4*i).z > DEM_R(0.0039));
        dem_world_destroy(world);
    }
    CHECK(hash[0] == hash[1] && hash[0] == hash[2]);
    remove(path);
}
static dem_world *rods(int other) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material m;
    dem_shape rod;
    int i;
    desc.gravity.z = DEM_R(-9.81);
    world = dem_world_create(&desc);
    m = scene_material(world, 1e6, 0.3, 0.5, 0);
    rod = dem_shape_capsule_add(world, other ? DEM_R(0.007) : DEM_R(0.006), DEM_R(0.004));
    dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
    for (i = 0; i < 8; i++)
        dem_body_add(world, m, rod, at(0.007*(i%4), 0.001*i, 0.006 + 0.009*(i/4)), dem_quat_make(1, DEM_R(0.9), 0, 0));
    return world;
}
/* Surfaces have all points on the capsule; replays have planes that touch it. */
static void rods_drawn(void) {
    dem_world *world = rods(0);
    demi_columns columns;
    demi_surfaces s;
    int i;
    memset(&s, 0, sizeof s);
    demi_surfaces_draw(world, &s);
    demi_columns_begin(&columns, world, "rods_drawn");
    s.place = demi_columns_reals(&columns, "Points", "position", 3, s.points);
    s.velocity = demi_columns_reals(&columns, "PointData", "velocity", 3, s.points);
    s.id = demi_columns_ints(&columns, "PointData", "id", 'u', s.points);
    s.material = demi_columns_ints(&columns, "PointData", "material", 'i', s.points);
    s.link = demi_columns_ints(&columns, "Polys", "connectivity", 'i', s.links);
    s.end = demi_columns_ints(&columns, "Polys", "offsets", 'i', s.polygons);
    CHECK(!columns.failed);
    s.points = s.polygons = s.links = 0;
    demi_surfaces_draw(world, &s);
    CHECK_EQ(s.points, 8*DEMI_ROUND_POINTS);
    for (i = 0; i < s.points; i++) {
        const int body = world->bodies.slot_index[s.id[i]];
        const dem_vec3 from = demi_sub(demi_at(s.place + 3*i), demi_at(world->bodies.pos + 4*body));
        const dem_vec3 axis = dem_quat_rotate(demi_quat_at(world->bodies.orient + 4*body), demi_v(0, 0, 1));
        const dem_real along = DEMI_MAX(DEM_R(-0.006), DEMI_MIN(DEM_R(0.006), demi_dot(from, axis)));
        CHECK_REL(demi_length(demi_sub(from, demi_scale(axis, along))), 0.004, 1e-6);
    }
    CHECK_EQ(demi_vtp(&columns, "build/recipes/rods.vtp", 0, 0, (int)s.polygons), DEM_OK);
    replay_has(world, ",100,40.09979,0,96.80946,");  /* the pole: 1/(0.006 + 0.004) per m */
    dem_world_destroy(world);
}
static void rods_refused(void) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world = dem_world_create(&desc);
    dem_material m = scene_material(world, 1e6, 0.5, 0, 0);
    dem_shape rod;
    CHECK_EQ(dem_shape_capsule_add(world, 0, 1).id, 0);
    CHECK_STR(dem_world_error_get(world), "half_length is 0");
    rod = dem_shape_capsule_add(world, DEM_R(0.01), DEM_R(0.004));
    CHECK_EQ(dem_shape_ellipsoid_add(world, at(1, 2, 3)).id, 0);
    CHECK_STR(dem_world_error_get(world), "dem_shape_ellipsoid_add: contacts between shape 2, an ellipsoid, and shape 1, "
                                      "a capsule, are not available");
    scene_floor(world, m, -0.1, -0.1, 0.1, 0.1, 3, 3);
    CHECK_EQ(dem_body_add(world, m, rod, at(0, 0, 1), dem_quat_make(1, 0, 0, 0)).slot, 0);
    CHECK_STR(dem_world_error_get(world), "wall 1 is a mesh and the body a capsule");
    dem_world_destroy(world);
}

/* Two spheres that a weld holds; sphere a alone spins at first. */
static dem_world *weld(int planar) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_joint_desc joint = DEM_JOINT_DESC;
    dem_world *world;
    dem_material m;
    desc.response = DEM_RESPONSE_IMPULSES;
    desc.dt = DEM_R(1e-3);
    desc.orientations = 1;
    desc.planar = planar;
    world = dem_world_create(&desc);
    m = scene_material(world, 1e6, 0.5, 0.5, 0);
    joint.a = dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, 0));
    joint.b = dem_sphere_add(world, m, DEM_R(0.01), at(0.03, 0, 0));
    joint.point = at(0.015, 0, 0);
    joint.kind = DEM_JOINT_FIXED;
    joint.speed = 7;                           /* of a motor, which it has not */
    CHECK_EQ(dem_joint_add(world, &joint).id, 1);
    scene_move(world, joint.a, at(0, 0, 0), planar ? at(0, 0, 60) : at(20, 30, 60));
    return world;
}
static void weld_holds(int planar) {
    const char *path = "build/recipes/weld.ckpt";
    dem_world *a = weld(planar), *b = weld(planar);
    const dem_body one = dem_body_id_get(a, 0), other = dem_body_id_get(a, 1);
    dem_joint_state state;
    dem_joint joint;
    double energy;
    joint.id = 1;
    CHECK_EQ(scene_step(a, 2), DEM_OK);
    energy = energy_of_motion(a);
    CHECK(energy > 1e-6);
    CHECK_EQ(scene_step(a, 500), DEM_OK);
    CHECK_EQ(dem_checkpoint_write(a, path), DEM_OK);
    CHECK_EQ(dem_checkpoint_read(b, path), DEM_OK);
    CHECK_EQ(scene_step(a, 500), DEM_OK);
    CHECK_EQ(scene_step(b, 500), DEM_OK);
    CHECK(dem_world_hash_get(a) == dem_world_hash_get(b));
    {
        const dem_body_state x = scene_state(a, one), y = scene_state(a, other);
        const dem_quat p = x.orientation, q = y.orientation;
        const double cosine = (double)(p.w*q.w + p.x*q.x + p.y*q.y + p.z*q.z);
        CHECK_REL(demi_length(demi_sub(y.position, x.position)), 0.03, 1e-5);
        CHECK_NEAR(demi_length(demi_sub(y.spin, x.spin)), 0, 1e-3);         /* of 8 rad/s */
        CHECK_NEAR(2*acos(DEMI_MIN(1, fabs(cosine))), 0, 0.01);         /* after some revolutions */
    }
    CHECK_REL(energy_of_motion(a), energy, 1e-3);
    CHECK_EQ(dem_joint_get(a, joint, &state), DEM_OK);
    CHECK_NEAR(state.gap, 0, 1e-8);
    CHECK_EQ(dem_joint_motor_set(a, joint, DEM_MOTOR_SPEED, 1, 0), DEM_ERROR_ARGUMENT);
    scene_report_has(a, "joint 1    force");
    remove(path);
    dem_world_destroy(a);
    dem_world_destroy(b);
}
/* A heap by impulses, swept to and fro. */
static dem_world *swept(int other) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material m;
    int i;
    desc.response = DEM_RESPONSE_IMPULSES;
    desc.dt = DEM_R(1e-3);
    desc.gravity.z = DEM_R(-9.81);
    desc.sweeps_alternate = !other;
    world = dem_world_create(&desc);
    m = scene_material(world, 1e6, 0.3, 0.5, 0);
    dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
    for (i = 0; i < 4; i++)
        dem_wall_plane_add(world, m, at(i == 0 ? -0.006 : i == 1 ? 0.04 : 0, i == 2 ? -0.006 : i == 3 ? 0.04 : 0, 0),
                           at(i == 0 ? 1 : i == 1 ? -1 : 0, i == 2 ? 1 : i == 3 ? -1 : 0, 0));
    for (i = 0; i < 64; i++)
        dem_sphere_add(world, m, DEM_R(0.005), at(0.0101*(i%4) + 0.001*(i/16), 0.0101*(i/4%4), 0.005 + 0.0101*(i/16)));
    return world;
}
/* A bed of softened grains. */
static dem_world *softened(int other) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material m;
    int i;
    desc.gravity.z = DEM_R(-9.81);
    desc.softening = other ? 0 : 32;
    world = dem_world_create(&desc);
    m = scene_material(world, 32e6, 0.9, 0.5, 0);
    dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
    for (i = 0; i < 18; i++)
        dem_sphere_add(world, m, DEM_R(0.005), at(0.0101*(i%3) + 0.002*(i/9), 0.0101*(i/3%3), 0.006 + 0.011*(i/9)));
    return world;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("recipe for a normal law: Kuwabara and Kono's dashpot, 1 - e ~ v^(1/5)") {
        dem_world_desc desc = DEM_WORLD_DESC;
        desc.normal_law = DEM_NORMAL_VISCOELASTIC;
        CHECK(1 - bounce(desc, 0.1) > 0.002);
        CHECK_REL((1 - bounce(desc, 3.2))/(1 - bounce(desc, 0.1)), 2, 0.05);
        serves(desc, "normal: viscoelastic");
        in_every_list(viscoelastic, "written with dissipation_time 1e-05 (dem_pair_set) of materials 1 and 1, this "
                      "world has 2e-05", "dissipation_time [s]", 1);
        closed_forms();
        desc.normal_law = (dem_normal_law)((int)DEM_NORMAL_VISCOELASTIC + 1);
        CHECK(dem_world_create(&desc) == 0);    /* the limit moved, and by one */
    }
    TEST("recipe for a friction law: a sliding ball comes to roll at 5/7 of its speed") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material m;
        dem_body ball;
        desc.tangent_law = DEM_TANGENT_SMOOTH;
        serves(desc, "tangential: smooth");
        desc.gravity.z = DEM_R(-9.81);
        world = dem_world_create(&desc);
        m = scene_material(world, 1e6, 0.5, 0.3, 0);
        dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        ball = dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, 0.01));
        scene_move(world, ball, at(0.5, 0, 0), at(0, 0, 0));
        CHECK_EQ(dem_world_run(world, 0.2, 0, 0), DEM_OK);
        CHECK_REL(scene_state(world, ball).velocity.x, 0.5*5/7, 0.01);
        dem_world_destroy(world);
    }
    TEST("recipe for a wall: in a shell a ball swings as a rolling pendulum, clusters rest on both spheres, "
         "ellipsoids and cubes on its facets") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_cluster_desc two = DEM_CLUSTER_DESC;
        static const dem_real places[6] = {DEM_R(-0.004), 0, 0, DEM_R(0.004), 0, 0};
        const char *path = "build/recipes/shell.ckpt";
        const double length = 0.5 - 0.01, start = 0.02;
        uint64_t hash[3] = {0, 0, 0};
        dem_material m;
        dem_body ball, others[2];
        dem_pose pose;
        int k;
        desc.gravity.z = DEM_R(-9.81);
        for (k = 0; k < 3; k++) {              /* 1 thread, 2 threads, on from a checkpoint */
            dem_world *world;
            dem_wall shell;
            desc.threads = 1 + (k == 1);
            world = dem_world_create(&desc);
            m = scene_material(world, 1e7, 0.5, 0.5, 0);
            shell = dem_wall_shell_add(world, m, at(0, 0, 1), DEM_R(0.5));
            CHECK_EQ(shell.id, 1);
            ball = dem_sphere_add(world, m, DEM_R(0.01), at(length*sin(start), 0,
                                                            1 - length*cos(start)));
            if (k < 2) CHECK_EQ(dem_world_run(world, 0.5, 0, 0), DEM_OK);
            if (k == 1) CHECK_EQ(dem_checkpoint_write(world, path), DEM_OK);
            if (k == 2) CHECK_EQ(dem_checkpoint_read(world, path), DEM_OK);
            /* half a period: pi sqrt(7 L/(5 g)) */
            CHECK_EQ(dem_world_run(world, 3.14159265358979*sqrt(1.4*length/9.81) - 0.5, 0, 0),
                     DEM_OK);
            CHECK_REL(scene_state(world, ball).position.x, -length*sin(start), 0.02);
            hash[k] = dem_world_hash_get(world);
            CHECK_EQ(dem_wall_pose_get(world, shell, &pose), DEM_OK);
            CHECK_NEAR(pose.position.z, 1, 1e-12);
            dem_world_destroy(world);
        }
        CHECK(hash[1] == hash[0] && hash[2] == hash[0]);
        {
            dem_world *world = dem_world_create(&desc);
            dem_shape pair;
            two.count = 2;
            two.positions = places;
            two.radius = DEM_R(0.005);
            m = scene_material(world, 1e6, 0.3, 0.5, 0.1);
            CHECK_EQ(dem_wall_shell_add(world, m, at(0, 0, 1), 0).id, 0);
            CHECK_STR(dem_world_error_get(world), "dem_wall_shell_add: radius is 0 m, must be > 0");
            CHECK_EQ(dem_wall_shell_add(world, m, at(0, 0, 1), DEM_R(0.05)).id, 1);
            pair = dem_shape_cluster_add(world, &two);
            ball = dem_body_add(world, m, pair, at(0.01, 0, 0.97), dem_quat_make(1, 0, 0, 0));
            CHECK_EQ(dem_world_run(world, 2, 0, 0), DEM_OK);
            {   /* on both of its spheres, wherever friction holds it */
                const dem_vec3 x = scene_state(world, ball).position;
                CHECK_NEAR(sqrt((double)(x.x*x.x + x.y*x.y + (x.z - 1)*(x.z - 1))),
                           sqrt(0.045*0.045 - 0.004*0.004), 1e-4);   /* pressed in 4e-5 m */
                CHECK_NEAR(demi_length(scene_state(world, ball).velocity), 0, 1e-3);
            }
            dem_world_destroy(world);
        }
        {
            dem_world *world = dem_world_create(&desc);
            m = scene_material(world, 1e6, 0.3, 0.5, 0.1);
            dem_wall_shell_add(world, m, at(0, 0, 1), DEM_R(0.05));
            for (k = 0; k < 2; k++)
                others[k] = dem_body_add(world, m, k ? scene_box(world, 0.01, 0.01, 0.01)
                                         : dem_shape_ellipsoid_add(world, at(0.006, 0.006, 0.004)),
                                         at(0, k ? 0.02 : -0.02, 0.97), dem_quat_make(1, 0, 0, 0));
            CHECK_EQ(dem_world_run(world, 0.1, 0, 0), DEM_OK);
            for (k = 0; k < 2; k++) {           /* on a side, an edge or a corner */
                const dem_vec3 x = scene_state(world, others[k]).position;
                const double off = sqrt((double)(x.x*x.x + x.y*x.y + (x.z - 1)*(x.z - 1)));
                CHECK(off > 0.05 - 0.0088 && off < 0.05 - 0.0038);
            }
            dem_world_destroy(world);
        }
        remove(path);
        in_every_list(shell, "written with radius 0.05 of wall 1, this world has 0.06", "wall 1     ", 1);
        shell_drawn();
    }
    TEST("recipe for a shape: capsules bounce without energy error, weigh and rotate as a row of balls, and rest "
         "among spheres") {
        rods_bounce();
        rods_weigh();
        rods_rest();
        rods_refused();
        rods_drawn();
        in_every_list(rods, "written with axes.z 0.006 of shape 1, this world has 0.007", "8 bodies are not spheres", 1);
    }
    TEST("recipe for a joint: a weld holds two spheres as one rigid body, in space and in the plane") {
        dem_world *world = weld(0);
        dem_joint_desc joint = DEM_JOINT_DESC;
        joint.kind = (dem_joint_kind)((int)DEM_JOINT_FIXED + 1);
        joint.a = dem_body_id_get(world, 0);
        CHECK_EQ(dem_joint_add(world, &joint).id, 0);
        CHECK_STR(dem_world_error_get(world), "kind is 4, must be > 0 and <= 3");
        dem_world_destroy(world);
        weld_holds(0);
        weld_holds(1);
    }
    TEST("recipe for an option of the impulses: the order of sweeps alternates, and a heap rests as before") {
        dem_world *world[2];
        int k;
        for (k = 0; k < 2; k++) {
            world[k] = swept(k);
            CHECK_EQ(scene_step(world[k], 400), DEM_OK);
            CHECK(energy_of_motion(world[k]) < 2e-5);      /* it fell by some 2e-2 J */
        }
        CHECK(dem_world_hash_get(world[0]) != dem_world_hash_get(world[1]));
        dem_world_destroy(world[0]);
        dem_world_destroy(world[1]);
        in_every_list(swept, "written with sweeps_alternate 1, this world has 0", "options    sweeps_alternate 1", 0);
    }
    TEST("recipe for a field of the desc: moduli softened 32 times lengthen a contact four times, restitution stays") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world[2];
        dem_coefficients k[2];
        dem_material m;
        int i;
        desc.softening = -1;
        CHECK(dem_world_create(&desc) == 0);
        CHECK_STR(dem_world_create_error_get(&desc), "softening must be 0 to 1e9");
        m.id = 1;
        for (i = 0; i < 2; i++) {
            world[i] = softened(i);
            CHECK_EQ(dem_coefficients_get(world[i], m, m, DEM_R(0.01), DEM_R(0.01), &k[i]), DEM_OK);
            CHECK_EQ(scene_step(world[i], 1), DEM_OK);
        }
        CHECK_REL(k[0].kn, k[1].kn/32, 1e-6);
        CHECK_REL(k[0].contact_time, 4*k[1].contact_time, 1e-6);            /* 32^(2/5) */
        CHECK_REL(world[0]->clock.dt, 4*world[1]->clock.dt, 1e-5);
        dem_world_destroy(world[0]);
        dem_world_destroy(world[1]);
        in_every_list(softened, "written with softening 32, this world has 0", "options    softening 32", 1);
    }
    TEST("recipe for a number of each body: it follows its body through sorts, removals, a "
         "checkpoint and slabs") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *a = mixture(desc, 1), *b = mixture(desc, 1);
        dem_slabs_desc deal = DEM_SLABS_DESC;
        dem_slabs *slabs;
        const char *path = "build/recipes/charge.ckpt";
        int i, round;
        for (i = 0; i < a->bodies.count; i++)
            a->bodies.charge[i] = (dem_real)(1 + a->bodies.slot[i]);
        dem_body_remove(a, dem_body_id_get(a, 5));
        CHECK_EQ(scene_step(a, 1000), DEM_OK);
        CHECK_EQ(dem_checkpoint_write(a, path), DEM_OK);
        dem_body_remove(b, dem_body_id_get(b, 5));
        CHECK_EQ(dem_checkpoint_read(b, path), DEM_OK);
        CHECK_EQ(b->bodies.count, 26);
        for (round = 0; round < 2; round++) {
            for (i = 0; i < b->bodies.count; i++)
                CHECK_NEAR(b->bodies.charge[i], (dem_real)(1 + b->bodies.slot[i]), 0);
            if (round) break;
            deal.count = 2;
            slabs = dem_slabs_create(b, &deal);
            CHECK_EQ(dem_slabs_step(slabs, 300), DEM_OK);
            for (i = 0; i < b->bodies.count; i++) b->bodies.charge[i] = 0;
            CHECK_EQ(dem_slabs_collect(slabs, b), DEM_OK);
            dem_slabs_destroy(slabs);
        }
        remove(path);
        dem_world_destroy(a);
        dem_world_destroy(b);
    }
    TEST("recipe for an integrator: exact where the force is constant") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_body ball;
        double t;
        desc.integrator = DEM_INTEGRATOR_TAYLOR;
        serves(desc, "Taylor (order 1)");
        desc.gravity.z = DEM_R(-9.81);
        desc.dt = DEM_R(1e-4);
        world = dem_world_create(&desc);
        ball = dem_sphere_add(world, scene_material(world, 1e6, 0.5, 0.3, 0), DEM_R(0.01), at(0, 0, 0));
        scene_step(world, 1000);
        t = dem_world_time_get(world);
        CHECK_REL(scene_state(world, ball).position.z, -9.81*t*t/2, 1e-10);
        CHECK_REL(scene_state(world, ball).velocity.z, -9.81*t, 1e-10);
        desc.integrator = (dem_integrator)((int)DEM_INTEGRATOR_TAYLOR + 1);
        CHECK(dem_world_create(&desc) == 0);
        dem_world_destroy(world);
    }
    TEST("recipe for a feature: a limit of kicks pushes deep overlaps apart gently, with slabs and after a restart too") {
        const char *path = "build/recipes/kicks.ckpt";
        double speed[4];
        int k;
        for (k = 0; k < 4; k++) {                  /* no limit; a limit; after a restart; two slabs */
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_slabs_desc split = DEM_SLABS_DESC;
            dem_body b[2];
            dem_world *w;
            dem_material m;
            int i;
            desc.dt = DEM_R(1e-6);
            desc.domain = box_of(-1, -1, -1, 1, 1, 1);
            w = dem_world_create(&desc);
            m = scene_material(w, 1e8, 0.5, 0, 0);
            for (i = 0; i < 2; i++) b[i] = dem_sphere_add(w, m, DEM_R(0.005), at(i ? 0.003 : -0.003, 0, 0));
            if (k) CHECK_EQ(dem_world_kick_limit_set(w, DEM_R(1e-3)), DEM_OK);
            if (k == 2) {
                CHECK_EQ(dem_checkpoint_write(w, path), DEM_OK);
                CHECK_EQ(dem_world_kick_limit_set(w, 0), DEM_OK);
                CHECK_EQ(dem_checkpoint_read(w, path), DEM_OK);
            }
            if (k == 3) {
                dem_slabs *slabs;
                split.count = 2;
                slabs = dem_slabs_create(w, &split);
                CHECK_EQ(dem_slabs_step(slabs, 10), DEM_OK);
                CHECK_EQ(dem_slabs_collect(slabs, w), DEM_OK);
                dem_slabs_destroy(slabs);
            } else CHECK_EQ(dem_world_step(w, 10), DEM_OK);
            speed[k] = (double)scene_state(w, b[1]).velocity.x;
            CHECK_EQ(dem_world_kick_limit_set(w, -1), DEM_ERROR_ARGUMENT);
            dem_world_destroy(w);
        }
        CHECK(speed[0] > 0.1);
        CHECK_NEAR(speed[1], 0.01, 1e-3);
        CHECK_NEAR(speed[2], speed[1], 0);
        CHECK_NEAR(speed[3], speed[1], 1e-12);
    }
    return test_end();
}
