/* Surfaces of revolution: finite cylinders, cones, discs, funnels. Against cylinders, planes and closed forms. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const int fine = sizeof(dem_real) == 8;       /* double precision */

static dem_world *world_of(double g, int ledger) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.gravity = at(0, 0, -g);
    desc.ledger = ledger;
    desc.dt = DEM_R(1e-5);                      /* that chosen follows from how high walls are */
    return dem_world_create(&desc);
}
static double apart(const dem_world *a, const dem_world *b) {
    double most = 0;
    int i;
    CHECK_EQ(dem_body_counts_get(a).present, dem_body_counts_get(b).present);
    for (i = 0; i < (int)dem_body_counts_get(a).present; i++) {
        const dem_body_state s = scene_state(a, dem_body_id_get(a, i)), t = scene_state(b, dem_body_id_get(b, i));
        most = fmax(most, (double)demi_length(demi_sub(s.position, t.position)));
    }
    return most;
}
static dem_wall tube_of(dem_world *world, dem_material m, int count, const double *r, const double *h) {
    dem_real radii[DEM_RINGS], heights[DEM_RINGS];
    int k;
    for (k = 0; k < count; k++) { radii[k] = (dem_real)r[k]; heights[k] = (dem_real)h[k]; }
    return dem_wall_revolved_add(world, m, at(0, 0, 0), at(0, 0, 1), count, radii, heights);
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("a long finite cylinder acts as the infinite one and a disc as a plane, with the same paths") {
        const dem_wall floor = {2};
        dem_wall_loads loads;
        dem_world *world[2];
        int k;
        for (k = 0; k < 2; k++) {
            dem_material m;
            world[k] = world_of(9.81, 0);
            m = scene_material(world[k], 1e6, 0.6, 0.4, 0.1);
            if (k) {
                dem_wall_cone_add(world[k], m, at(0, 0, -0.5), at(0, 0, 0.5), DEM_R(0.02), DEM_R(0.02));
                dem_wall_cone_add(world[k], m, at(0, 0, 0), at(0, 0, 1e-9), 0, DEM_R(0.5));
            } else {
                dem_wall_cylinder_add(world[k], m, at(0, 0, 0), at(0, 0, 1), DEM_R(0.02), 1);
                dem_wall_plane_add(world[k], m, at(0, 0, 0), at(0, 0, 1));
            }
            for (int i = 0; i < 5; i++) {
                const dem_body b = dem_sphere_add(world[k], m, DEM_R(0.004), at(0.003*i - 0.006, 0.004, 0.01 + 0.01*i));
                scene_move(world[k], b, at(0.3, 0.2*i, 0), at(0, 20, 0));
            }
            CHECK_EQ(dem_world_run_to(world[k], 0.1, 0, 0), DEM_OK);
        }
        /* the disc is a cone of 1e-9 m height on .5 m */
        dem_wall_loads_get(world[0], floor, &loads);
        CHECK(loads.touched);
        dem_wall_loads_get(world[1], floor, &loads);
        CHECK(loads.touched);
        CHECK_NEAR(apart(world[0], world[1]), 0, fine ? 1e-7 : 1e-4);
        for (k = 0; k < 2; k++) dem_world_destroy(world[k]);
    }

    TEST("a grain in a cone presses along the normal; inner corners give two contacts, outer ones the ring, straight "
         "joins no seam") {
        static const double bowl_r[] = {0.05, 0.05, 0}, bowl_h[] = {0.1, 0, -0.05};
        static const double roof_r[] = {0.05, 0.02, 0.02}, roof_h[] = {0, 0.03, 0.1};
        dem_world *world = world_of(0, 0);
        dem_material m = scene_material(world, 1e6, 0.6, 0, 0);
        const double R = 0.01, deep = 1e-4, c = sqrt(0.5);
        dem_contact_info info[4];
        dem_body ball = dem_sphere_add(world, m, (dem_real)R, at(0, 0, 0));
        dem_body_state s = scene_state(world, ball);
        dem_wall wall = tube_of(world, m, 3, bowl_r, bowl_h);
        CHECK_EQ(wall.id, 1);
        /* the cone's surface is r = .05 + z: inward normal (-1, 1)/sqrt 2; a ball over the point at z = -.02 */
        s.position = at(0, 0.03 - c*(R - deep), -0.02 + c*(R - deep));
        dem_body_set(world, ball, &s);
        CHECK_EQ(dem_candidates_rebuild(world), DEM_OK);
        CHECK_EQ(scene_step(world, 0), DEM_OK);
        CHECK_EQ(scene_step(world, 1), DEM_OK);
        CHECK_EQ(dem_contacts_get(world, info, 4), 1);
        CHECK_NEAR(info[0].overlap, deep, 1e-6);
        CHECK_NEAR(info[0].normal.y, c, fine ? 1e-9 : 1e-4);
        CHECK_NEAR(info[0].normal.z, -c, fine ? 1e-9 : 1e-4);
        /* the inner corner of tube and cone at (.05, 0): both, each as deep as its own distance says */
        s.position = at(0, 0.05 - R + deep, 0);
        s.velocity = at(0, 0, 0);
        /* the cone is (z - r + .05)/sqrt 2 away: so that both are R - deep */
        s.position.z = (dem_real)((R - deep)/c - (R - deep));
        dem_body_set(world, ball, &s);
        CHECK_EQ(dem_candidates_rebuild(world), DEM_OK);
        CHECK_EQ(scene_step(world, 1), DEM_OK);
        CHECK_EQ(dem_contacts_get(world, info, 4), 2);
        CHECK_NEAR(info[0].overlap, deep, 2e-6);
        CHECK_NEAR(info[1].overlap, deep, 2e-6);
        CHECK_EQ(dem_wall_remove(world, wall), DEM_OK);
        /* a roof with a chimney: from outside the eaves are a rim, their normal between the pieces */
        wall = tube_of(world, m, 3, roof_r, roof_h);
        s.position = at(0, 0.05 + 0.8*(R - deep), -0.6*(R - deep));
        s.velocity = at(0, 0, 0);
        dem_body_set(world, ball, &s);
        CHECK_EQ(dem_candidates_rebuild(world), DEM_OK);
        CHECK_EQ(scene_step(world, 1), DEM_OK);
        CHECK_EQ(dem_contacts_get(world, info, 4), 1);
        CHECK_NEAR(info[0].normal.y, -0.8, 1e-3);
        CHECK_NEAR(info[0].normal.z, 0.6, 1e-3);
        dem_world_destroy(world);
        /* a cone in one piece and the same in three */
        {
            static const double one_r[] = {0.05, 0.01}, one_h[] = {0.08, 0};
            static const double three_r[] = {0.05, 0.04, 0.02, 0.01}, three_h[] = {0.08, 0.06, 0.02, 0};
            dem_world *pair[2];
            int k, i;
            for (k = 0; k < 2; k++) {
                pair[k] = world_of(9.81, 0);
                m = scene_material(pair[k], 1e6, 0.6, 0, 0);
                if (k) tube_of(pair[k], m, 4, three_r, three_h);
                else tube_of(pair[k], m, 2, one_r, one_h);
                for (i = 0; i < 6; i++) {
                    const dem_body b = dem_sphere_add(pair[k], m, DEM_R(0.004), at(0.03*cos(i), 0.03*sin(i), 0.08));
                    scene_move(pair[k], b, at(0, 0.05*i, 0), at(0, 0, 0));
                }
                CHECK_EQ(dem_world_run_to(pair[k], 0.15, 0, 0), DEM_OK);
            }
            CHECK_NEAR(apart(pair[0], pair[1]), 0, fine ? 1e-7 : 1e-3);
            for (k = 0; k < 2; k++) dem_world_destroy(pair[k]);
        }
    }

    TEST("a ball sliding through a bowl of rings at an overlap of R/10 keeps its energy at each ring, however blunt") {
        int rings;
        for (rings = 4; rings <= DEM_RINGS && fine; rings += 4) {
            double r[DEM_RINGS], h[DEM_RINGS], before, after, worst = 0;
            dem_world *world = world_of(9.81, 1);
            dem_material m = scene_material(world, 3e5, 1, 0, 0);
            dem_body ball;
            int k, deepest = 0;
            for (k = 0; k < rings; k++) {       /* the lower half of a ball of 5 cm */
                r[k] = 0.05*sin(1.5707963267948966*k/(rings - 1));
                h[k] = -0.05*cos(1.5707963267948966*k/(rings - 1));
            }
            CHECK(tube_of(world, m, rings, r, h).id);
            ball = dem_sphere_add(world, m, DEM_R(0.01), at(0.038, 0.002, 0));
            scene_move(world, ball, at(0, 0.3, 0), at(0, 0, 0));
            before = dem_ledger_get(world).kinetic;
            for (k = 0; k < 300; k++) {
                dem_ledger l;
                CHECK_EQ(scene_step(world, 100), DEM_OK);
                l = dem_ledger_get(world);
                after = l.kinetic + l.elastic - l.gravity;
                worst = fmax(worst, fabs(after - before)/(before + fabs(l.gravity)));
                deepest += dem_counters_get(world).overlap_max > DEM_R(0.05);
            }
            CHECK(worst < 1e-4);
            CHECK(deepest > 0);
            if (getenv("REVOLVED_NUMBERS")) printf("%d rings: %g\n", rings, worst);
            dem_world_destroy(world);
        }
        CHECK(1);
    }

    TEST("a drum with ends, a cone and a neck confines its gas with constant energy, also rotating and shaken") {
        static const double r[] = {0, 0.03, 0.03, 0.012, 0.012, 0}, h[] = {0, 0, 0.03, 0.05, 0.07, 0.07};
        int moving;
        for (moving = 0; moving < 3; moving++) {
            dem_world *world = world_of(0, 1);
            dem_material m = scene_material(world, 1e7, 1, moving == 1 ? 0.3 : 0, 0);
            const dem_wall wall = tube_of(world, m, 6, r, h);
            dem_motion motion = DEM_MOTION;
            dem_region region;
            dem_shape none;
            dem_totals before, after;
            uint64_t seed = 3;
            int i;
            none.id = 0;
            memset(&region, 0, sizeof region);
            region.box = box_of(-0.029, -0.029, 0.001, 0.029, 0.029, 0.029);
            region.cylinder = 'z';
            CHECK_EQ(dem_spheres_fill(world, m, DEM_R(0.002), region, 150, 1), 150);
            for (i = 0; i < 150; i++)
                scene_move(world, dem_body_id_get(world, i), scene_at(&seed, 1, -0.5, 1, -0.5, 1, -0.5), at(0, 0, 0));
            motion.kind = moving == 1 ? DEM_MOTION_ROTATING : moving == 2 ? DEM_MOTION_OSCILLATING : DEM_MOTION_FIXED;
            motion.axis = at(0, 0, 1);
            motion.speed = 10;
            motion.velocity = at(1, 0, 1);
            motion.amplitude = DEM_R(0.002);
            motion.frequency = 10;
            CHECK_EQ(dem_wall_motion_set(world, wall, &motion), DEM_OK);
            before = dem_totals_get(world);
            CHECK_EQ(dem_world_run_to(world, 0.5, 0, 0), DEM_OK);
            after = dem_totals_get(world);
            if (!moving) CHECK_REL(after.kinetic, before.kinetic, 0.02);
            CHECK_NEAR(dem_ledger_get(world).residual, 0, 5e-3*dem_ledger_get(world).throughput + 0.02*before.kinetic);
            for (i = 0; i < 150; i++) {
                const dem_vec3 x = scene_state(world, dem_body_id_get(world, i)).position;
                if (!(sqrt((double)(x.x*x.x + x.y*x.y)) < 0.032 && (double)x.z > -0.003 && (double)x.z < 0.073)) CHECK(0);
            }
            dem_world_destroy(world);
        }
    }

    TEST("clusters slide down a cone as down its mesh, and a funnel carries the weight of its contents") {
        dem_world *world = world_of(9.81, 0);
        dem_material m = scene_material(world, 2e6, 0.3, 0.5, 0.1);
        static const dem_real two[] = {DEM_R(-0.002), 0, 0, DEM_R(0.002), 0, 0};
        static const double r[] = {0.03, 0.03, 0.001}, h[] = {0.1, 0.03, 0};
        dem_cluster_desc pair = DEM_CLUSTER_DESC;
        dem_wall wall = tube_of(world, m, 3, r, h);
        dem_wall_loads loads;
        dem_shape shape;
        pair.count = 2;
        pair.positions = two;
        pair.radius = DEM_R(0.003);
        shape = dem_shape_cluster_add(world, &pair);
        CHECK_EQ(dem_bodies_fill(world, m, shape,
                                 dem_region_make(box_of(-0.018, -0.018, 0.03, 0.018, 0.018, 0.1)), 40, 1), 40);
        CHECK_EQ(dem_world_settle(world, 3, DEM_R(0.003), 0, 0), DEM_OK);
        dem_wall_loads_reset(world, wall);
        CHECK_EQ(dem_world_run(world, 0.05, 0, 0), DEM_OK);
        dem_wall_loads_get(world, wall, &loads);
        CHECK_REL(-loads.impulse[2]/loads.time, 9.81*dem_totals_get(world).mass, 0.02);
        dem_world_destroy(world);
    }

    TEST("periodic images of a funnel repel alike, and files and checkpoints hold its rings") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world[2];
        dem_material m;
        int k, i;
        for (k = 0; k < 2; k++) {
            desc.gravity = at(0, 0, -9.81);
            desc.boundary[0] = DEM_BOUNDARY_PERIODIC;
            desc.domain = box_of(k ? 0.05 : 0, -1, -1, k ? 0.15 : 0.1, 1, 1);
            world[k] = dem_world_create(&desc);
            m = scene_material(world[k], 1e6, 0.6, 0.3, 0);
            dem_wall_cone_add(world[k], m, at(0.02, 0, 0), at(0.02, 0, 0.04), DEM_R(0.002), DEM_R(0.04));
            for (i = 0; i < 8; i++)
                dem_sphere_add(world[k], m, DEM_R(0.004), at(0.02 + 0.025*cos(i), 0.025*sin(i), 0.045 + 0.001*i));
            CHECK_EQ(dem_world_run_to(world[k], 0.1, 0, 0), DEM_OK);
        }
        for (i = 0; i < 8; i++) {
            const dem_body_state a = scene_state(world[0], dem_body_id_get(world[0], i));
            int j, found = 0;
            for (j = 0; j < 8; j++) {
                const dem_body_state b = scene_state(world[1], dem_body_id_get(world[1], j));
                const double x = fabs((double)(a.position.x - b.position.x)), tiny = fine ? 1e-9 : 1e-4;
                found += (x < tiny || fabs(x - 0.1) < tiny) && fabs((double)(a.position.z - b.position.z)) < tiny &&
                         fabs((double)(a.position.y - b.position.y)) < tiny;
            }
            CHECK_EQ(found, 1);
        }
        CHECK_EQ(dem_walls_vtp_write(world[0], "build/tmp/revolved.vtp", 0, 1), DEM_OK);
        CHECK_EQ(dem_checkpoint_write(world[0], "build/tmp/revolved.ckpt"), DEM_OK);
        dem_world_destroy(world[1]);
        desc.domain = box_of(0, -1, -1, 0.1, 1, 1);
        world[1] = dem_world_create(&desc);
        m = scene_material(world[1], 1e6, 0.6, 0.3, 0);
        dem_wall_cone_add(world[1], m, at(0.02, 0, 0), at(0.02, 0, 0.04), DEM_R(0.003), DEM_R(0.04));
        CHECK_EQ(dem_checkpoint_read(world[1], "build/tmp/revolved.ckpt"), DEM_ERROR_FORMAT);
        CHECK_STR(dem_world_error_get(world[1]), "of wall 1, this world has");
        for (k = 0; k < 2; k++) dem_world_destroy(world[k]);
    }

    TEST("rings that form no surface are rejected with the ring's number") {
        dem_world *world = world_of(0, 0);
        dem_material m = scene_material(world, 1e6, 0.6, 0.3, 0);
        static const double r[] = {0.1, 0.1, 0, 0}, h[] = {0, 0, 1, 2};
        dem_real bad[2] = {1, -1}, up[2] = {0, 1};
        CHECK_EQ(tube_of(world, m, 1, r, h).id, 0);
        CHECK_STR(dem_world_error_get(world), "count is 1");
        CHECK_EQ(tube_of(world, m, 2, r, h).id, 0);
        CHECK_STR(dem_world_error_get(world), "ring 1 has radius 0.1 m at height 0 m");
        CHECK_EQ(tube_of(world, m, 2, r + 2, h + 2).id, 0);
        CHECK_STR(dem_world_error_get(world), "not 0 for two rings in a row");
        CHECK_EQ(dem_wall_revolved_add(world, m, at(0, 0, 0), at(0, 0, 0), 2, up, up).id, 0);
        CHECK_EQ(dem_wall_revolved_add(world, m, at(0, 0, 0), at(0, 0, 1), 2, bad, up).id, 0);
        CHECK_STR(dem_world_error_get(world), "ring 1 has radius -1 m");
        CHECK_EQ(dem_wall_revolved_add(world, m, at(0, 0, 0), at(0, 0, 1), 2, 0, up).id, 0);
        CHECK_EQ(dem_wall_cone_add(world, m, at(0, 0, 1), at(0, 0, 1), 1, 1).id, 0);
        dem_world_destroy(world);
    }
    return test_end();
}
