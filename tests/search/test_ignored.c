/* Pairs of materials that ignore each other (dem_pair.ignored): no contact anywhere, for all walls, shapes, responses
   and searches, and everything else as if the other were not there. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static void ignore(dem_world *world, dem_material a, dem_material b, int ignored) {
    dem_pair pair;
    CHECK_EQ(dem_pair_get(world, a, b, &pair), DEM_OK);
    pair.ignored = ignored;
    CHECK_EQ(dem_pair_set(world, a, b, &pair), DEM_OK);
}
static void must(dem_world *world, dem_result result) {
    CHECK_EQ(result, DEM_OK);
    if (result != DEM_OK) puts(dem_world_error_get(world));
}

/* ---- one body of each of two materials flies at a wall or a body ---- */

enum { BALL, EGG, PAIR, CUBE, ROCK, SHAPES };
static const char *const shapes[] = {"ball", "ellipsoid", "cluster", "polyhedron", "union"};
static dem_shape shape_of(dem_world *world, int kind) {
    dem_real corner[24];
    int k;
    static const dem_real two[6] = {0, DEM_R(-2e-3), 0, 0, DEM_R(2e-3), 0};
    static const dem_real apart_x[6] = {DEM_R(-3e-3), 0, 0, DEM_R(3e-3), 0, 0};
    dem_cluster_desc cluster = DEM_CLUSTER_DESC;
    dem_shape none;
    none.id = 0;
    for (k = 0; k < 24; k++) corner[k] = (k/3 >> k%3 & 1) ? DEM_R(4e-3) : DEM_R(-4e-3);
    cluster.count = 2;
    cluster.positions = two;
    cluster.radius = DEM_R(4e-3);
    if (kind == EGG) return dem_shape_ellipsoid_add(world, at(5e-3, 4e-3, 4e-3));
    if (kind == PAIR) return dem_shape_cluster_add(world, &cluster);
    if (kind == CUBE) return dem_shape_polyhedron_add(world, 8, corner);
    if (kind == ROCK) {
        dem_shape part[2];
        part[0] = part[1] = dem_shape_polyhedron_add(world, 8, corner);
        return dem_shape_union_add(world, 2, part, apart_x, 0);
    }
    return none;
}
static dem_body thrown(dem_world *world, dem_material stuff, dem_shape shape, dem_vec3 x, double speed) {
    const dem_body body = shape.id ? dem_body_add(world, stuff, shape, x, dem_quat_make(1, 0, 0, 0))
                                   : dem_sphere_add(world, stuff, DEM_R(5e-3), x);
    scene_move(world, body, at(speed, 0, 0), at(0, 0, 0));
    return body;
}
enum { PLANE, MESH, CYLINDER, PROFILE, SIEVE, REVOLVED, GRAINS, BODY, TARGETS };
static const char *const targets[] = {"plane", "mesh", "cylinder", "profile", "sieve", "surface of revolution",
                                      "wall of grains", "body"};
/* What stands at x = 0, facing -x, near y = 0.1 and y = -0.1. */
static void target_add(dem_world *world, dem_material stuff, int kind, dem_shape shape) {
    static const dem_real corner[12] = {0, -1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1};
    static const int32_t triangle[6] = {0, 1, 2, 0, 2, 3};
    static const dem_real line[4] = {0, -1, 0, 1}, radius[2] = {2, 2}, height[2] = {-1, 1};
    static const dem_real grain[6] = {DEM_R(0.01), DEM_R(0.1), 0, DEM_R(0.01), DEM_R(-0.1), 0};
    static const int32_t segment[2] = {0, 1};
    dem_mesh mesh;
    dem_profile profile;
    dem_sieve_desc sieve = DEM_SIEVE_DESC;
    profile.vertex_count = 2;
    profile.segment_count = 1;
    profile.vertices = (dem_real *)line;
    profile.segments = (int32_t *)segment;
    memset(&mesh, 0, sizeof mesh);
    mesh.vertex_count = 4;
    mesh.triangle_count = 2;
    mesh.vertices = (dem_real *)corner;
    mesh.triangles = (int32_t *)triangle;
    sieve.kind = DEM_SIEVE_SQUARE;
    sieve.normal = at(1, 0, 0);
    sieve.aperture = DEM_R(1e-4);
    sieve.bar = 1;
    sieve.point = at(0, 0.6, 0.6);
    if (kind == PLANE) dem_wall_plane_add(world, stuff, at(0, 0, 0), at(-1, 0, 0));
    if (kind == MESH) dem_wall_mesh_add(world, stuff, &mesh);
    if (kind == CYLINDER) dem_wall_cylinder_add(world, stuff, at(2, 0, 0), at(0, 0, 1), 2, 0);
    if (kind == PROFILE) dem_wall_profile_add(world, stuff, &profile, DEM_EDGE_RESOLVED);
    if (kind == SIEVE) dem_wall_sieve_add(world, stuff, &sieve);
    if (kind == REVOLVED) dem_wall_revolved_add(world, stuff, at(2, 0, 0), at(0, 0, 1), 2, radius, height);
    if (kind == GRAINS) dem_wall_grains_add(world, stuff, 2, grain, DEM_R(0.01), 1);
    if (kind == BODY) {
        const dem_body up = thrown(world, stuff, shape, at(6e-3, 0.1, 0), 0);
        const dem_body down = thrown(world, stuff, shape, at(6e-3, -0.1, 0), 0);
        CHECK(up.slot && down.slot);
    }
}
static void throws_at(int target, int kind, dem_response response) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material felt, through, wall;
    dem_shape shape;
    dem_body a, b;
    double back, on;
    desc.threads = 1;
    desc.response = response;
    if (response == DEM_RESPONSE_IMPULSES) desc.dt = DEM_R(1e-4);
    desc.ledger = response == DEM_RESPONSE_SPRINGS;
    world = dem_world_create(&desc);
    felt = scene_material(world, 1e8, 0.7, 0.3, 0);
    through = scene_material(world, 1e8, 0.7, 0.3, 0);
    wall = scene_material(world, 1e8, 0.7, 0.3, 0);
    ignore(world, through, wall, 1);
    shape = shape_of(world, kind);
    target_add(world, wall, target, shape);
    a = thrown(world, felt, shape, at(-0.012, 0.1, 0), 1);
    b = thrown(world, through, shape, at(-0.012, -0.1, 0), 1);
    if (!strcmp(dem_world_error_get(world), "")) {
        must(world, dem_world_run(world, 0.03, 0, 0));
        back = (double)scene_state(world, a).velocity.x;
        on = (double)scene_state(world, b).velocity.x;
        if (!(back < 0.2) || fabs(on - 1) > 1e-6) printf("    %s at %s\n", shapes[kind], targets[target]);
        CHECK(back < 0.2);                      /* it hit a wall, or a body at rest */
        CHECK_NEAR(on, 1, sizeof(dem_real) == 8 ? 1e-12 : 1e-6);
        if (desc.ledger) CHECK(fabs(dem_ledger_get(world).residual) < 1e-3*dem_ledger_get(world).inserted);
    } else if (!strstr(dem_world_error_get(world), "not available")) puts(dem_world_error_get(world));
    dem_world_destroy(world);
}

/* ---- a mixture of two species that ignore each other ---- */

enum { MOST = 250 };
static double pulls_told;
static void pulls(const dem_contact *c, dem_real *memory, dem_contact_force *force) {
    const int a = c->material_a < c->material_b ? c->material_a : c->material_b;
    const int b = c->material_a + c->material_b - a;
    pulls_told += a != b && !(a == 1 && b == 3);
    dem_law_hertz(c, memory, force);
    if (c->overlap < 0) force->normal = (dem_real)(-1e-3*(5e-4 + (double)c->overlap)/5e-4);
}
static dem_world *mixture(dem_response response, int law, int threads, int other, dem_material *stuff) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    int k;
    desc.domain = box_of(0, 0, 0, 0.05, 0.03, 0.03);
    desc.boundary[0] = desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
    desc.threads = threads;
    desc.response = response;
    desc.dt = (dem_real)(response == DEM_RESPONSE_IMPULSES ? 2e-4 : 5e-6);
    desc.sweeps = 50;
    if (law) { desc.law = pulls; desc.law_range = DEM_R(5e-4); }
    world = dem_world_create(&desc);
    for (k = 0; k < 3; k++) stuff[k] = scene_material(world, 1e7, 0.8, 0.4, 0);
    ignore(world, stuff[0], stuff[1], 1);
    ignore(world, stuff[1], stuff[2], 1);
    dem_wall_plane_add(world, stuff[2], at(0.0, 0, 0.005), at(0, 0, 1));
    k = dem_spheres_fill(world, stuff[0], DEM_R(1e-3), dem_region_make(box_of(0, 0, 0.0055, 0.05, 0.03, 0.03)), MOST, 1);
    CHECK_EQ(k, MOST);
    if (other) {
        k = dem_spheres_fill(world, stuff[1], DEM_R(1e-3), dem_region_make(box_of(0, 0, 0, 0.05, 0.03, 0.03)), MOST, 2);
        CHECK_EQ(k, MOST);
    }
    for (k = 0; k < dem_bodies_get(world).count; k++) {
        const dem_body id = dem_body_id_get(world, k);
        uint64_t state = id.slot;
        const dem_vec3 v = scene_at(&state, 2, -1, 2, -1, 2, -1);
        scene_move(world, id, v, at(0, 0, 0));
    }
    return world;
}
/* Largest distance, m, of the first species from where it is in another world. */
static double apart(const dem_world *a, const dem_world *b) {
    double most = 0;
    int k;
    for (k = 0; k < MOST; k++) {
        dem_body id;
        id.slot = (uint32_t)k + 1;
        id.generation = 1;
        most = fmax(most, fabs((double)scene_state(a, id).position.x - (double)scene_state(b, id).position.x));
    }
    return most;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("a material passes through the walls and bodies that it ignores, and another one bounces") {
        int target, kind;
        for (target = 0; target < TARGETS; target++)
            for (kind = 0; kind < SHAPES; kind++) {
                throws_at(target, kind, DEM_RESPONSE_SPRINGS);
                throws_at(target, kind, DEM_RESPONSE_IMPULSES);
            }
    }
    TEST("two species that ignore each other move as if each was alone") {
        int response, law;
        for (response = 0; response < 2; response++)
            for (law = 0; law < (response ? 1 : 2); law++) {
                const dem_response how = response ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS;
                dem_material stuff[3];
                dem_world *alone = mixture(how, law, 1, 0, stuff), *both = mixture(how, law, 2, 1, stuff);
                const int steps = response ? 15 : 250;
                pulls_told = 0;
                must(alone, dem_world_step(alone, steps));
                must(both, dem_world_step(both, steps));
                /* the order of sums differs, and collisions amplify it */
                CHECK_NEAR(apart(alone, both), 0, sizeof(dem_real) == 4 ? 3e-4 : response ? 1e-7 : 1e-11);
                CHECK_EQ(pulls_told, 0);
                CHECK(dem_counters_get(both).contacts > 0);
                dem_world_destroy(alone);
                dem_world_destroy(both);
            }
    }
    TEST("a ball on two halves of a floor falls when it ignores both, and lands when it feels them again") {
        int mesh, shape;
        for (mesh = 0; mesh < 2; mesh++)
            for (shape = BALL; shape < SHAPES; shape++) {
                static dem_real corner[2][12] = {{-1, -1, 0, 0, -1, 0, 0, 1, 0, -1, 1, 0},
                                                 {0, -1, 0, 1, -1, 0, 1, 1, 0, 0, 1, 0}};
                static int32_t triangle[6] = {0, 1, 2, 0, 2, 3};
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_world *world;
                dem_material left, right, stuff;
                dem_mesh half;
                dem_body ball;
                double z, v, t;
                desc.gravity = at(0, 0, -10);
                desc.threads = 1;
                world = dem_world_create(&desc);
                stuff = scene_material(world, 1e7, 0.1, 0.4, 0);
                left = scene_material(world, 1e7, 0.1, 0.4, 0);
                right = scene_material(world, 1e7, 0.1, 0.4, 0);
                memset(&half, 0, sizeof half);
                half.vertex_count = 4;
                half.triangle_count = 2;
                half.triangles = triangle;
                half.vertices = corner[0];
                if (mesh) dem_wall_mesh_add(world, left, &half);
                else dem_wall_plane_add(world, left, at(0, 0, 0), at(0, 0, 1));
                half.vertices = corner[1];
                if (mesh) dem_wall_mesh_add(world, right, &half);
                ball = thrown(world, stuff, shape_of(world, shape), at(1e-4, 0, 5e-3), 0);
                must(world, dem_world_run(world, 0.15, 0, 0));
                z = (double)scene_state(world, ball).position.z;
                v = (double)scene_state(world, ball).velocity.z;
                CHECK(fabs(v) < 1e-3);
                ignore(world, stuff, left, 1);
                if (mesh) {                     /* the other half still holds it, by half of it */
                    must(world, dem_world_run(world, 0.001, 0, 0));
                    CHECK(dem_counters_get(world).wall_contacts > 0);
                    ignore(world, stuff, right, 1);
                    v = (double)scene_state(world, ball).velocity.z;
                    z = (double)scene_state(world, ball).position.z;
                }
                t = -dem_world_time_get(world);
                must(world, dem_world_run(world, 0.01, 0, 0));
                t += dem_world_time_get(world);
                CHECK_NEAR(scene_state(world, ball).position.z, z + v*t - 5*t*t, 2e-3*5*t*t);
                CHECK_EQ(dem_counters_get(world).wall_contacts, 0);
                ignore(world, stuff, left, 0);
                must(world, dem_world_step(world, 1));
                CHECK(dem_counters_get(world).wall_contacts > 0);
                dem_world_destroy(world);
            }
    }
    TEST("a stiff pair that is ignored limits no time step, and its friction switches on no law") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material soft, hard, wall;
        double dt[2], k;
        int i;
        for (i = 0; i < 2; i++) {
            desc.threads = 1;
            world = dem_world_create(&desc);
            soft = scene_material(world, 1e6, 0.5, 0, 0);
            hard = scene_material(world, 1e6, 0.5, 0, 0);
            wall = scene_material(world, 1e12, 0.5, 0, 0);
            if (i) {
                dem_pair pair;
                CHECK_EQ(dem_pair_get(world, hard, wall, &pair), DEM_OK);
                pair.young_eff = DEM_R(1e12);
                pair.friction = 1;
                pair.ignored = 1;
                CHECK_EQ(dem_pair_set(world, hard, wall, &pair), DEM_OK);
                ignore(world, soft, wall, 1);
            }
            dem_sphere_add(world, soft, DEM_R(1e-3), at(0, 0, 0));
            dem_sphere_add(world, hard, DEM_R(1e-3), at(0, 0, 0.01));
            if (i) dem_wall_plane_add(world, wall, at(0, 0, 0), at(0, 0, 1));
            must(world, dem_world_step(world, 1));
            dt[i] = (double)world->clock.dt;
            if (i) scene_report_has(world, "tangential: none");
            k = dem_world_check(world, 0, 0);
            CHECK(k >= 0);
            dem_world_destroy(world);
        }
        CHECK_NEAR(dt[1], dt[0], 1e-12);
    }
    TEST("only 0 and 1 are values of ignored") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world = dem_world_create(&desc);
        const dem_material stuff = scene_material(world, 1e7, 0.5, 0, 0);
        dem_pair pair;
        CHECK_EQ(dem_pair_get(world, stuff, stuff, &pair), DEM_OK);
        CHECK_EQ(pair.ignored, 0);
        pair.ignored = 2;
        CHECK_EQ(dem_pair_set(world, stuff, stuff, &pair), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "ignored of materials 1 and 1 is 2");
        dem_world_destroy(world);
    }
    return test_end();
}
