/* Impacts of convex polyhedra by the hundred thousand, by springs: rocks, cubes, tetrahedra and flakes on their like, on a
   plane, inside and outside a tube, on the ridge of a mesh, on a union, on sieves and on edges of sheets and pipes, at random
   angles, spins, restitutions and frictions. None may leave with more energy than it came with, beyond the step's own error,
   and elastic ones lose none.
   A world holds many lanes, far from each other, with one impact each. TEST_LONG makes 1e5 of them, TEST_TABLES prints
   the worst of each kind. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

typedef enum stone_target { on_stone, on_floor, in_tube, on_tube, on_roof, on_pair, on_weave, on_holes, on_rounds, on_edge,
                            on_rim, on_hood, stone_targets } stone_target;
static const char *const stone_target_name[stone_targets] = {"its like", "a plane", "the inside of a tube", "a tube",
                                                             "a roof of triangles", "a union", "a weave of wires",
                                                             "a plate with square holes", "a plate with round holes",
                                                             "the edge of an upright sheet", "the end of a thin pipe",
                                                             "a hood of triangles"};
enum { stone_lanes = 120, stone_shapes = 12 };
typedef struct stone_lane { dem_body a, b; double before; } stone_lane;
typedef struct stone_sum { int hits, gaining; double worst, elastic; } stone_sum;

static dem_vec3 stone_direction(uint64_t *seed) {
    const double z = 2*scene_random(seed) - 1, a = 6.283185307179586*scene_random(seed), s = sqrt(1 - z*z);
    return at(s*cos(a), s*sin(a), z);
}
/* J, of one body; the tube, if there is one, is at rest. */
static double stone_energy(const dem_world *world, dem_body body) {
    const int i = world->bodies.slot_index[body.slot - 1];
    const dem_vec3 v = demi_at(world->bodies.vel + 4*i), spin = demi_at(world->bodies.spin + 4*i);
    return (double)world->bodies.mass[i]*(double)demi_dot(v, v)/2 + (double)demi_dot(spin, demi_angular_of(world, i))/2;
}
static dem_shape stone_add(dem_world *world, uint64_t *seed, int kind) {
    dem_real p[120];
    int i, k, n = kind%4 == 0 ? 8 : kind%4 == 1 ? 4 : 10 + 2*kind;
    for (i = 0; i < n; i++) {
        const dem_vec3 x = stone_direction(seed);
        if (kind%4 == 0) for (k = 0; k < 3; k++) p[3*i + k] = i >> k & 1 ? DEM_R(0.58) : DEM_R(-0.58);
        else if (kind%4 == 1) for (k = 0; k < 3; k++) p[3*i + k] = (i == k || i == 3) ? DEM_R(0.58) : DEM_R(-0.58);
        else {
            p[3*i] = x.x;
            p[3*i + 1] = x.y*DEM_R(0.8);
            p[3*i + 2] = x.z*(kind%4 == 3 ? DEM_R(0.25) : DEM_R(0.7));     /* flakes */
        }
    }
    return dem_shape_polyhedron_add(world, n, p);
}
/* Where the middle of lane i is: so far from the next that what flies off meets nobody else's. */
static dem_vec3 stone_place(stone_target target, int i) {
    return target == in_tube || target == on_tube ? at(0, 0, 24.0*i) : at(24.0*(i%12), 24.0*(i/12), 0);
}
/* Those that take long. */
static int stone_slow(int target) {
    return target == on_weave || target == on_holes || target == on_rounds || target == on_rim;
}
/* A surface of triangles without thickness about c: a ridge of two slopes, one turned the other way; an upright sheet; a
   tent of four slopes, open at one of them and cut off below. */
static void stone_sheet(dem_world *world, dem_material m, stone_target target, dem_vec3 c) {
    static const double roof[18] = {-4, -4, -2, 4, -4, -2, -4, 4, -2, 4, 4, -2, -4, 0, 0, 4, 0, 0};
    static const double edge[12] = {-3, 0, -3, 3, 0, -3, 3, 0, 0, -3, 0, 0};
    static const double hood[15] = {-2, -2, -1.5, 2, -2, -1, 2, 2, -1.5, -2, 2, -1, 0.3, 0.1, 0};
    static int32_t on_slopes[12] = {0, 1, 5, 0, 5, 4, 2, 4, 5, 2, 3, 5}, upright[6] = {0, 1, 2, 0, 2, 3};
    static int32_t tent[9] = {0, 1, 4, 4, 2, 1, 2, 3, 4};
    const double *x = target == on_roof ? roof : target == on_edge ? edge : hood;
    dem_real v[18];
    dem_mesh mesh;
    int k;
    mesh.vertex_count = target == on_roof ? 6 : target == on_edge ? 4 : 5;
    mesh.triangle_count = target == on_roof ? 4 : target == on_edge ? 2 : 3;
    mesh.triangles = target == on_roof ? on_slopes : target == on_edge ? upright : tent;
    mesh.vertices = v;
    for (k = 0; k < 3*mesh.vertex_count; k++)
        v[k] = (k%3 == 0 ? c.x : k%3 == 1 ? c.y : c.z) + (dem_real)x[k];
    CHECK(dem_wall_mesh_add(world, m, &mesh).id);
}
/* What stands still in all lanes. */
static void stone_walls(dem_world *world, dem_material m, stone_target target) {
    int i;
    if (target == on_floor) dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
    if (target == in_tube) dem_wall_cylinder_add(world, m, at(0, 0, 0), at(0, 0, 1), 4, 1);
    if (target == on_tube) dem_wall_cylinder_add(world, m, at(0, 0, 0), at(0, 0, 1), 2, 0);
    if (target == on_weave || target == on_holes || target == on_rounds) {
        dem_sieve_desc s = DEM_SIEVE_DESC;
        s.kind = target == on_weave ? DEM_SIEVE_WIRES : target == on_holes ? DEM_SIEVE_SQUARE : DEM_SIEVE_ROUND;
        s.aperture = DEM_R(1.2);
        s.bar = DEM_R(0.6);
        s.thickness = target == on_weave ? 0 : DEM_R(0.5);
        s.lift = target == on_weave ? DEM_R(0.5) : 0;
        CHECK(dem_wall_sieve_add(world, m, &s).id);
    }
    for (i = 0; i < stone_lanes; i++) {
        static const dem_real radii[2] = {2, DEM_R(1.6)}, heights[2] = {-3, 0};
        const dem_vec3 c = stone_place(target, i);
        if (target == on_roof || target == on_edge || target == on_hood) stone_sheet(world, m, target, c);
        if (target == on_rim) CHECK(dem_wall_revolved_add(world, m, c, at(0, 0, 1), 2, radii, heights).id);
    }
}
/* Impacts of one kind in so many lanes. restitution 1 and no friction: elastic. */
static void stones_throw(stone_target target, int lanes, int elastic, uint64_t seed, stone_sum *sum) {
    dem_world_desc desc = DEM_WORLD_DESC;
    const double e = elastic ? 1 : 0.3 + 0.6*scene_random(&seed);
    dem_material_desc stuff = scene_stuff(1e8, e, elastic ? 0 : scene_random(&seed), 0);
    stone_lane lane[stone_lanes];
    dem_shape shapes[stone_shapes], pair = {0};
    dem_world *world;
    dem_material m;
    int i;
    desc.normal_law = seed & 4 ? DEM_NORMAL_HERTZ : DEM_NORMAL_LINEAR;
    desc.impact_speed = 3;
    desc.threads = 1;
    world = dem_world_create(&desc);
    m = dem_material_add(world, &stuff);
    for (i = 0; i < stone_shapes; i++) shapes[i] = stone_add(world, &seed, i);
    if (target == on_pair) {
        dem_shape two[2];
        const dem_real x[6] = {DEM_R(-0.5), 0, 0, DEM_R(0.6), DEM_R(0.2), 0};
        two[0] = shapes[0];
        two[1] = shapes[2];
        pair = dem_shape_union_add(world, 2, two, x, 0);
    }
    stone_walls(world, m, target);
    for (i = 0; i < lanes; i++) {
        const dem_vec3 way = stone_direction(&seed), aside = scene_at(&seed, 1, -0.5, 1, -0.5, 1, -0.5);
        const dem_vec3 middle = stone_place(target, i);
        const dem_quat q = dem_quat_about(stone_direction(&seed), (dem_real)(6*scene_random(&seed)));
        const double fast = 1 + 2*scene_random(&seed);
        dem_vec3 x = demi_add(middle, demi_scale(way, DEM_R(-3.2))), v = demi_scale(way, (dem_real)fast);
        lane[i].b.slot = 0;
        if (target == on_floor || target == on_roof || target >= on_weave) {
            const double turn = 6.28*(double)aside.x;
            x = demi_add(middle, at(0, (double)aside.y*3, 2.2));
            if (target == on_edge || target == on_hood) x = demi_add(middle, at((double)aside.x*6, (double)aside.y*2, 1.8));
            if (target == on_rim) x = demi_add(middle, at((1.6 + aside.y)*cos(turn), (1.6 + aside.y)*sin(turn), 1.8));
            v = at(fast*(double)aside.x, fast*(double)aside.y, -fast);
        } else if (target == in_tube || target == on_tube) {
            const double angle = 6.28*scene_random(&seed), out = target == in_tube ? 2.6 : 3.3;
            const double in = target == in_tube ? 1 : -1;
            x = demi_add(middle, at(out*cos(angle), out*sin(angle), 0));
            v = at(fast*in*cos(angle) + (double)aside.x, fast*in*sin(angle) + (double)aside.y, (double)aside.z);
        } else {
            const dem_quat turned = dem_quat_about(stone_direction(&seed), (dem_real)(6*scene_random(&seed)));
            lane[i].b = dem_body_add(world, m, target == on_pair ? pair : shapes[(i/stone_shapes)%stone_shapes], middle, turned);
            scene_move(world, lane[i].b, at(0, 0, 0), demi_scale(stone_direction(&seed), (dem_real)(2*scene_random(&seed))));
            x = demi_add(x, demi_scale(aside, DEM_R(1.2)));
        }
        lane[i].a = dem_body_add(world, m, shapes[i%stone_shapes], x, q);
        scene_move(world, lane[i].a, v, demi_scale(stone_direction(&seed), (dem_real)(3*scene_random(&seed))));
        lane[i].before = stone_energy(world, lane[i].a) + (lane[i].b.slot ? stone_energy(world, lane[i].b) : 0);
    }
    CHECK_EQ(dem_world_run(world, 2.5, 0, 0), DEM_OK);
    if (*dem_world_error_get(world)) printf("%s: %s\n", stone_target_name[target], dem_world_error_get(world));
    for (i = 0; i < lanes; i++) {
        double after = stone_energy(world, lane[i].a), gain;
        int k, touching = 0;
        if (lane[i].b.slot) after += stone_energy(world, lane[i].b);
        gain = after/lane[i].before - 1;
        for (k = 0; k < world->domain_count; k++) {    /* still at it: energy is in the springs */
            const demi_persistent *c = demi_persistent_of(world, k);
            int j;
            for (j = 0; j < world->domains[k].persistent; j++)
                touching |= c[j].overlap > 0 && (world->bodies.slot[c[j].a] + 1 == lane[i].a.slot ||
                                                 (c[j].b >= 0 && world->bodies.slot[c[j].b] + 1 == lane[i].a.slot));
        }
        if (touching) continue;
        sum->hits += fabs(gain) > 1e-13;
        sum->worst = fmax(sum->worst, gain);
        sum->gaining += gain > 1e-3;
        if (elastic) sum->elastic = fmax(sum->elastic, -gain);
    }
    dem_world_destroy(world);
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("polyhedra: no impact on any body or surface gains 1/1000 of its energy, and elastic "
         "impacts lose no more") {
        const int rounds = getenv("TEST_LONG") ? 160 : 1;
        stone_sum all = {0, 0, 0, 0};
        int target, round;
        for (target = 0; target < stone_targets && sizeof(dem_real) == 8; target++) {
            stone_sum sum = {0, 0, 0, 0};
            for (round = 0; round < rounds/(rounds > 8 && stone_slow(target) ? 8 : 1); round++)    /* these take long */
                stones_throw((stone_target)target, rounds == 1 && stone_slow(target) ? 24 : stone_lanes, round%4 == 0,
                             (uint64_t)(1000*target + round + 1), &sum);
            if (getenv("TEST_TABLES"))
                printf("on %s: %d impacts, worst gain %.2g, worst elastic loss %.2g\n", stone_target_name[target], sum.hits, sum.worst,
                       sum.elastic);
            all.hits += sum.hits;
            all.gaining += sum.gaining;
            all.worst = fmax(all.worst, sum.worst);
            all.elastic = fmax(all.elastic, sum.elastic);
        }
        printf("impacts = %d\nimpacts_gaining = %d\n", all.hits, all.gaining);
        CHECK_EQ(all.gaining, 0);
        CHECK(all.elastic < 1e-3);
        CHECK(sizeof(dem_real) == 4 || all.hits > 200);
    }

    return test_end();
}
