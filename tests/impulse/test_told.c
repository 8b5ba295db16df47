/* What the solved impulses become: forces on bodies and the list of contacts. Each test goes over the kinds of
   grains. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

enum { BALL, CLUMP, EGG, CUBE, MIXED, KINDS };
static const double round_off = sizeof(dem_real) == 4 ? 1e-5 : 1e-12;

/* A world without gravity, with a shape of each kind: ids 1 to 3 for CLUMP to CUBE. */
static dem_world *made(double dt, double friction, double restitution, dem_material *m) {
    static const dem_real two[6] = {DEM_R(-5e-4), 0, 0, DEM_R(5e-4), 0, 0};
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_cluster_desc clump = DEM_CLUSTER_DESC;
    dem_world *world;
    desc.response = DEM_RESPONSE_IMPULSES;
    desc.dt = (dem_real)dt;
    desc.threads = 1;
    desc.orientations = 1;
    world = dem_world_create(&desc);
    *m = scene_material(world, 0, restitution, friction, 0);
    clump.count = 2;
    clump.positions = two;
    clump.radius = DEM_R(8e-4);
    clump.mass = DEM_CLUSTER_SUM;
    dem_shape_cluster_add(world, &clump);
    dem_shape_ellipsoid_add(world, at(1.04e-3, 1.057e-3, 1.39e-3));
    scene_box(world, 1.3e-3, 1.3e-3, 1.6e-3);
    return world;
}
static dem_body grain(dem_world *world, dem_material m, int kind, dem_vec3 x, dem_quat q) {
    dem_shape shape;
    shape.id = kind;
    return kind == BALL ? dem_sphere_add(world, m, DEM_R(1e-3), x) : dem_body_add(world, m, shape, x, q);
}
/* 40 grains that fly about, in a box or in free space. Their ids are the same in every world. */
static dem_body grains[40];
static void fill(dem_world *world, dem_material m, int kind, int walls, uint64_t seed) {
    int i, k;
    for (k = 0; k < 3 && walls; k++) {
        const double n[3] = {k == 0, k == 1, k == 2}, to = k == 2 ? 8.1e-3 : 0.0112;
        dem_wall_plane_add(world, m, at(-1.6e-3*n[0], -1.6e-3*n[1], -1.6e-3*n[2]), at(n[0], n[1], n[2]));
        dem_wall_plane_add(world, m, at(to*n[0], to*n[1], to*n[2]), at(-n[0], -n[1], -n[2]));
    }
    for (i = 0; i < 40; i++) {
        const dem_vec3 x = at(0.0032*(i%4), 0.0032*(i/4%4), 0.0032*(i/16));
        const dem_quat q = scene_turn(&seed);
        const dem_vec3 v = scene_at(&seed, 2, -1, 2, -1, 2, -1);
        grains[i] = grain(world, m, kind == MIXED ? i%MIXED : kind, x, q);
        scene_move(world, grains[i], v, scene_at(&seed, 200, -100, 200, -100, 200, -100));
    }
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("impulses: the torque on a grain that touches nothing is exactly 0, whatever its shape") {
        int kind, k;
        for (kind = BALL; kind < MIXED; kind++) {
            dem_material m;
            dem_world *world = made(1e-4, 0.3, 0.5, &m);
            const dem_body b = grain(world, m, kind, at(0, 0, 0), dem_quat_make(1, 0, 0, 0));
            scene_move(world, b, at(1, 2, 3), at(50, 60, -70));
            for (k = 0; k < 50; k++) {
                dem_body_state s;
                CHECK_EQ(scene_step(world, 1), DEM_OK);
                s = scene_state(world, b);
                CHECK(!(fabs((double)s.torque.x) + fabs((double)s.torque.y) + fabs((double)s.torque.z) > 0));
            }
            dem_world_destroy(world);
        }
    }
    TEST("impulses: the listed forces on a grain are m dv/dt - m g, for grains of every kind and for walls") {
        static const char path[] = "build/tmp/told.ckpt";
        static dem_contact_info list[2000], again[2000];
        int kind, steps, i, n;
        for (kind = BALL; kind < KINDS; kind++) {
            dem_material m;
            dem_world *world = made(1e-4, 0.3, 0.5, &m), *other = made(1e-4, 0.3, 0.5, &m);
            int pushed = 0, borne = 0;        /* contacts of two grains, and of a grain and a wall */
            fill(world, m, kind, 1, 5);
            fill(other, m, kind, 1, 6);
            dem_world_gravity_set(world, at(0, 0, -10));
            CHECK_EQ(scene_step(world, 1), DEM_OK);
            for (steps = 0; steps < 300; steps++) {
                dem_body_state before[40], now;
                dem_vec3 sum[40];
                memset(sum, 0, sizeof sum);
                n = dem_contacts_get(world, list, 2000);
                for (i = 0; i < n; i++) {
                    dem_vec3 *a = &sum[list[i].a.slot - 1], *b = list[i].wall ? 0 : &sum[list[i].b.slot - 1];
                    const dem_vec3 f = list[i].force;
                    *a = dem_vec3_make(a->x + f.x, a->y + f.y, a->z + f.z);
                    if (b) *b = dem_vec3_make(b->x - f.x, b->y - f.y, b->z - f.z);
                    if (list[i].wall) borne++; else pushed++;
                }
                for (i = 0; i < 40; i++) before[i] = scene_state(world, grains[i]);
                CHECK_EQ(scene_step(world, 1), DEM_OK);
                for (i = 0; i < 40; i++) {
                    const double per = (double)before[i].mass/1e-4, near = 2*round_off*per; /* 2 m/s */
                    now = scene_state(world, grains[i]);
                    CHECK_NEAR(sum[i].x, per*((double)now.velocity.x - (double)before[i].velocity.x), near);
                    CHECK_NEAR(sum[i].y, per*((double)now.velocity.y - (double)before[i].velocity.y), near);
                    CHECK_NEAR(sum[i].z, per*((double)now.velocity.z - (double)before[i].velocity.z + 1e-3), near);
                    CHECK_NEAR(sum[i].x, before[i].force.x, near);
                }
            }
            CHECK(pushed > 100 && borne > 100);
            n = dem_contacts_get(world, list, 2000);
            dem_world_gravity_set(other, at(0, 0, -10));
            CHECK_EQ(dem_checkpoint_write(world, path), DEM_OK);
            CHECK_EQ(dem_checkpoint_read(other, path), DEM_OK);
            CHECK_EQ(dem_contacts_get(other, again, 2000), n);
            for (i = 0; i < n; i++) CHECK(!memcmp(&list[i].force, &again[i].force, sizeof list[i].force));
            dem_world_destroy(world);
            dem_world_destroy(other);
        }
        remove(path);
    }
    return test_end();
}
