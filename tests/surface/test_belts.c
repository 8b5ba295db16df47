/* Surfaces that move in themselves: the rims of a belt create no energy. The relation "belt or moving wall"
   (tests/relations) checks that a belt carries grains as a wall that really moves. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const int fine = sizeof(dem_real) == 8;       /* double precision */
static const double R = 0.005;                       /* m, of grains */

static dem_world *stage(int impulses, int planar, double dt, double friction, dem_material *m) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = scene_stuff(1e7, 0.5, friction, 0);
    dem_world *world;
    desc.ledger = 1;
    desc.planar = planar;
    if (planar) desc.gravity.y = DEM_R(-9.81);
    else desc.gravity.z = DEM_R(-9.81);
    desc.dt = (dem_real)dt;
    desc.response = impulses ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS;
    world = dem_world_create(&desc);
    if (!world) { puts(dem_world_create_error_get(&desc)); exit(1); }
    *m = dem_material_add(world, &stuff);
    return world;
}
enum { BALL, CLUSTER, ELLIPSOID, CUBE };
static dem_body grain(dem_world *world, dem_material m, int shape, dem_vec3 x) {
    const dem_real pair[6] = {DEM_R(-0.001), 0, 0, DEM_R(0.001), 0, 0};
    dem_cluster_desc two = DEM_CLUSTER_DESC;
    dem_shape s;
    two.count = 2; two.positions = pair; two.radius = DEM_R(0.8*0.005);
    switch (shape) {
    case CLUSTER: s = dem_shape_cluster_add(world, &two); break;
    case ELLIPSOID: s = dem_shape_ellipsoid_add(world, at(1.2*R, R, 0.8*R)); break;
    case CUBE: s = scene_box(world, 1.6*R, 1.6*R, 1.6*R); break;
    default: return dem_sphere_add(world, m, (dem_real)R, x);
    }
    return dem_body_add(world, m, s, x, dem_quat_about(at(1, 2, 3), DEM_R(0.3)));
}
enum { FLAT, TUBE, CONE, RING, PROFILE, MESH, SLAB, BEADS, SIEVE, WALLS };
static dem_wall belt(dem_world *world, dem_material m, int wall) {
    dem_real p[24], q[8] = {DEM_R(-0.1), 0, 0, 0, DEM_R(0.05), DEM_R(0.01), DEM_R(0.1), 0};
    int32_t quad[6] = {0, 1, 2, 0, 2, 3}, legs[6] = {0, 1, 1, 2, 2, 3};
    static const int32_t faces[36] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2,
                                      1, 3, 7, 1, 7, 5};
    dem_real radii[3] = {0, DEM_R(0.05), DEM_R(0.05)}, heights[3] = {0, 0, DEM_R(-0.02)};
    dem_mesh mesh;
    dem_profile profile;
    dem_sieve_desc sieve = DEM_SIEVE_DESC;
    dem_wall none;
    int i;
    none.id = 0;
    mesh.vertices = p; mesh.triangles = quad; mesh.vertex_count = 4; mesh.triangle_count = 2;
    for (i = 0; i < 4; i++) {
        p[3*i] = DEM_R(i == 0 || i == 3 ? -0.05 : 0.05);
        p[3*i + 1] = DEM_R(i < 2 ? -0.05 : 0.05);
        p[3*i + 2] = 0;
    }
    switch (wall) {
    case FLAT: return dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
    case TUBE: return dem_wall_cylinder_add(world, m, at(0, 0, 0.1), at(1, 0.2, 0), DEM_R(0.1), 1);
    case CONE: return dem_wall_cone_add(world, m, at(0, 0, 0), at(0, 0, -0.05), DEM_R(0.02), DEM_R(0.05));
    case RING: return dem_wall_revolved_add(world, m, at(0, 0, 0), at(0, 0, 1), 3, radii, heights);
    case PROFILE:
        profile.vertex_count = 4; profile.segment_count = 3;
        profile.vertices = q; profile.segments = legs;
        return dem_wall_profile_add(world, m, &profile, DEM_EDGE_RESOLVED);
    case MESH: return dem_wall_mesh_add(world, m, &mesh);
    case SLAB:
        scene_box_points(0.1, 0.1, 0.02, p);
        for (i = 0; i < 8; i++) p[3*i + 2] -= DEM_R(0.01);
        mesh.vertex_count = 8; mesh.triangle_count = 12; mesh.triangles = (int32_t *)faces;
        return dem_wall_mesh_add(world, m, &mesh);
    case BEADS: {
        dem_real x[75];
        for (i = 0; i < 25; i++) {
            x[3*i] = (dem_real)(0.004*(i%5 - 2)); x[3*i + 1] = (dem_real)(0.004*(i/5 - 2)); x[3*i + 2] = DEM_R(-0.004);
        }
        return dem_wall_grains_add(world, m, 25, x, DEM_R(0.004), DEM_R(0.5));
    }
    case SIEVE:
        sieve.kind = DEM_SIEVE_WIRES; sieve.aperture = DEM_R(0.004); sieve.bar = DEM_R(0.002);
        return dem_wall_sieve_add(world, m, &sieve);
    }
    return none;
}
/* Drops a grain of a shape on a belt of a kind; returns the residual over the throughput. The ledger books whole steps, and
   velocities have half a kick of the last one: what a contact that slides at the end does in that time is not counted. */
static double residual(int impulses, int shape, int wall, dem_vec3 x, double dt, double time) {
    dem_material m;
    dem_world *world = stage(impulses, 0, dt, 0.5, &m);
    const dem_wall b = belt(world, m, wall);
    dem_ledger l;
    dem_wall_loads loads;
    if (wall == PROFILE) {
        dem_world_gravity_set(world, at(0, -9.81, 0));
        x = at((double)x.x, (double)x.z, 0);
    }
    CHECK_EQ(dem_wall_surface_velocity_set(world, b, at(1, 0.3, 0.1)), DEM_OK);
    grain(world, m, shape, x);
    CHECK_EQ(dem_world_run(world, time, 0, 0), DEM_OK);
    l = dem_ledger_get(world);
    CHECK(fabs(l.walls) > 0.1*l.throughput);            /* it was on the belt */
    dem_wall_loads_get(world, b, &loads);
    dem_world_destroy(world);
    return fmax(fabs(l.residual) - fabs((double)loads.power)*dt, 0)/l.throughput;
}
/* Grains on a belt that stops a third of the way, and rotates with its table; *belt receives the wall. */
static dem_world *table(int impulses, int periodic, dem_wall *wall) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_motion turn = DEM_MOTION;
    dem_world *world;
    dem_material m;
    uint64_t seed = 5;
    int i;
    desc.gravity.z = DEM_R(-9.81);
    desc.dt = impulses ? DEM_R(2e-4) : DEM_R(2e-5);
    desc.response = impulses ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS;
    desc.threads = 1;
    desc.ledger = 1;
    if (periodic) {
        desc.domain = box_of(-0.05, -0.05, -1, 0.05, 0.05, 1);
        desc.boundary[0] = desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
    }
    world = dem_world_create(&desc);
    m = scene_material(world, 1e7, 0.5, 0.5, 0);
    *wall = belt(world, m, SLAB);
    if (!periodic) {
        turn.kind = DEM_MOTION_ROTATING;
        turn.axis = at(0, 0, 1);
        turn.speed = 8;
        dem_wall_motion_set(world, *wall, &turn);
    }
    CHECK_EQ(dem_wall_surface_velocity_set(world, *wall, at(0.5, 0.2, 0)), DEM_OK);
    for (i = 0; i < 100; i++) {
        const dem_vec3 x = scene_at(&seed, 4e-4, 0.0085*(i%10 - 4.5), 4e-4, 0.0085*(i/10 - 4.5), 0.001, i%7 ? 0.005 : 0.02);
        if (i%7) dem_sphere_add(world, m, DEM_R(0.004), x);
        else grain(world, m, i%2 ? CUBE : CLUSTER, x);
    }
    return world;
}
static uint64_t digest(dem_world *world) {
    dem_candidates_rebuild(world);
    return dem_world_hash_get(world);
}
/* A motion that lies about its velocity from time 0.1 s on. */
static void lying(double time, dem_pose *pose, void *user) {
    const int what = *(const int *)user;
    const double w = 300;
    if (what == 1) {                            /* all right: a vibration */
        pose->position.z = (dem_real)(1e-3*sin(w*time));
        pose->velocity.z = (dem_real)(1e-3*w*cos(w*time));
    } else if (what == 2) pose->velocity.x = 1;
    else if (what == 3) pose->spin.z = 2;
    else if (time > 0.1) pose->position.x = (dem_real)(0.2*(time - 0.1));
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("a ball, a cluster and a cube on every rim of a belt keep the residual of the ledger below 1e-6 of the throughput") {
        static const double far[WALLS] = {0, 0.02, 0.021, 0.052, 0.1, 0.052, 0.052, 0.011, 0.052};
        int wall, shape, place, imp;
        for (wall = 0; wall < WALLS; wall++) for (place = 0; place < 4; place++) for (shape = 0; shape <= CUBE; shape++)
            for (imp = 0; imp < 2; imp++) {
                const double a = far[wall];
                const dem_vec3 x = wall == PROFILE && !place ? at(0.05, 0, 0.018) : wall == SIEVE && !place ? at(0.003, 0.003, 0.008) : place == 3 ? at(0.7*a, 0.7*a, 0.008) : place == 2 ? at(-a, 0, 0.008)
                    : place ? at(a, 0, 0.008) : at(0, a, 0.008);
                double off;
                if (shape == ELLIPSOID || (wall == FLAT && place) || (wall == TUBE && place != 1) || (wall == SIEVE && shape) ||
                    (shape && wall != SLAB && (imp || wall != RING)) || (!fine && imp) || (!fine && place)) continue;
                if (wall == PROFILE && place == 3) continue;
                off = residual(imp, shape, wall, x, !fine ? 1e-5 : imp ? 2e-5 : 2.5e-6, imp ? 0.05 : 0.035);
                if (getenv("BELT_NUMBERS")) printf("wall %d place %d shape %d impulses %d: %.1e\n", wall, place, shape, imp, off);
                CHECK(off < (!fine ? 2e-2 : shape == CUBE && !imp ? 5e-6 : 1e-6));  /* a cube slides on several corners */
            }
    }
    TEST("the drag on a belt is the mass flow times its speed") {
        dem_world_desc desc = DEM_WORLD_DESC;
        const dem_material_desc stuff = scene_stuff(3e5, 0.3, 0.6, 0.3);
        dem_feed_desc feed = DEM_FEED_DESC;
        dem_wall_loads l;
        dem_world *world;
        dem_material m;
        dem_wall b, side;
        int k;
        desc.gravity.z = DEM_R(-9.81);
        desc.domain = box_of(-1, -0.05, -0.02, 1, 0.05, 0.2);
        desc.boundary[2] = DEM_BOUNDARY_OUTFLOW;
        desc.impact_speed = DEM_R(0.5);
        world = dem_world_create(&desc);
        m = dem_material_add(world, &stuff);
        b = scene_floor(world, m, -0.06, -0.05, 0.06, 0.05, 2, 1);
        for (k = 0; k < 2; k++) {
            side = dem_wall_plane_add(world, m, at(0, k ? 0.03 : -0.03, 0), at(0, k ? -1 : 1, 0));
            CHECK_EQ(dem_wall_surface_velocity_set(world, side, at(0, 3, 0)), DEM_OK);   /* across: none of it is seen */
        }
        CHECK_EQ(dem_wall_surface_velocity_set(world, b, at(0.5, 0, 0)), DEM_OK);
        feed.material = m;
        feed.class_count = 1;
        feed.radius[0] = DEM_R(0.004);
        feed.amount[0] = 40;
        feed.limited = 1;
        feed.rate = 200;
        feed.box = box_of(-0.05, -0.015, 0.006, -0.03, 0.015, 0.01);
        dem_feed_add(world, &feed);
        CHECK_EQ(dem_world_run(world, 0.6, 0, 0), DEM_OK);      /* until the last has left */
        CHECK_EQ(dem_body_counts_get(world).present, 0);
        dem_wall_loads_get(world, b, &l);
        CHECK_REL(-l.impulse[0]/0.2, 200*2500*4.0/3*3.14159265358979*0.004*0.004*0.004*0.5, 0.01);  /* N; the feed lasts 0.2 s */
        CHECK_REL(l.work, -l.impulse[0]*0.5, 1e-2);             /* power: force times speed, except at the rim */
        dem_world_destroy(world);
    }
    TEST("a surface velocity rotates with its wall, is in checkpoints, in slabs, and across periodic faces") {
        int imp, periodic;
        for (imp = 0; imp < 2; imp++) for (periodic = 0; periodic < 2; periodic++) {
            const int half = imp ? 60 : 600;
            char path[] = "build/tmp/test_belts.checkpoint";
            dem_wall wall;
            dem_vec3 v;
            dem_world *whole = table(imp, periodic, &wall), *again;
            dem_ledger l;
            CHECK_EQ(scene_step(whole, half), DEM_OK);
            dem_wall_surface_velocity_get(whole, wall, &v);
            if (!periodic) {
                const double turned = 8*(double)dem_world_time_get(whole);
                CHECK_NEAR(v.x, 0.5*cos(turned) - 0.2*sin(turned), 1e-6);
                CHECK_NEAR(v.y, 0.5*sin(turned) + 0.2*cos(turned), 1e-6);
            }
            CHECK_EQ(dem_checkpoint_write(whole, path), DEM_OK);
            CHECK_EQ(scene_step(whole, half), DEM_OK);
            l = dem_ledger_get(whole);
            if (getenv("BELT_NUMBERS")) printf("%d %d: %g %g\n", imp, periodic, l.residual, l.throughput);
            CHECK(fabs(l.residual) < (fine ? 1e-3 : 2e-2)*l.throughput);
            again = table(imp, periodic, &wall);
            dem_wall_surface_velocity_set(again, wall, at(0, 0, 0));
            CHECK_EQ(dem_checkpoint_read(again, path), DEM_OK);
            CHECK_EQ(scene_step(again, half), DEM_OK);
            CHECK(digest(again) == digest(whole));
            dem_world_destroy(again);
            dem_world_destroy(whole);
            if (!imp) {
                dem_world *world = table(0, periodic, &wall), *one = table(0, periodic, &wall);
                dem_slabs_desc desc = DEM_SLABS_DESC;
                dem_slabs *slabs;
                dem_wall_loads a, b;
                desc.count = 2;
                slabs = dem_slabs_create(world, &desc);
                CHECK(slabs != 0);
                CHECK_EQ(dem_slabs_step(slabs, half/2), DEM_OK);
                CHECK_EQ(dem_slabs_collect(slabs, world), DEM_OK);
                CHECK_EQ(scene_step(one, half/2), DEM_OK);
                dem_wall_loads_get(world, wall, &a);
                dem_wall_loads_get(one, wall, &b);
                CHECK_REL(a.impulse[0], b.impulse[0], fine ? 1e-6 : 2e-2);
                CHECK_REL(a.work, b.work, fine ? 1e-6 : 2e-2);
                dem_slabs_destroy(slabs);
                dem_world_destroy(world);
                dem_world_destroy(one);
            }
            remove(path);
        }
    }
    TEST("a world check names a user-defined motion whose velocity is not the derivative of its position") {
        int what, kind;
        for (what = 0; what < 4; what++) for (kind = 0; kind < 2; kind++) {
            dem_finding found[8];
            dem_motion motion = DEM_MOTION;
            dem_material m;
            dem_world *world = stage(0, 0, 1e-5, 0.5, &m);
            const dem_wall b = belt(world, m, kind ? MESH : FLAT);
            int n, i, named = 0;
            motion.kind = DEM_MOTION_USER;
            motion.function = lying;
            motion.user = &what;
            CHECK_EQ(dem_wall_motion_set(world, b, &motion), DEM_OK);
            dem_sphere_add(world, m, (dem_real)R, at(0, 0, 2*R));
            n = dem_world_check(world, found, 8);
            for (i = 0; i < n; i++) named += strstr(found[i].text, "dem_wall_surface_velocity_set") != 0;
            /* of a plane, what moves it along itself matters to nobody */
            CHECK_EQ(named, what == 1 ? 0 : what == 3 ? 1 : kind);
            if (named) CHECK(strstr(found[0].text, what == 3 ? "spin of (0, 0, 2)" : what ? "velocity of (1, 0, 0)"
                                    : "changes by (0.2, 0, 0)") != 0);
            dem_world_destroy(world);
        }
    }
    TEST("dem.h refuses a surface velocity that is not finite, or across a planar world") {
        dem_material m;
        dem_world *world = stage(0, 1, 1e-5, 0.5, &m);
        const dem_wall b = dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 1, 0));
        dem_wall none;
        dem_vec3 v;
        none.id = 7;
        CHECK_EQ(dem_wall_surface_velocity_set(world, none, at(1, 0, 0)), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "wall 7 does not exist");
        CHECK_EQ(dem_wall_surface_velocity_set(world, b, at(HUGE_VAL, 0, 0)), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "must be finite");
        CHECK_EQ(dem_wall_surface_velocity_set(world, b, at(0, 0, 1)), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "must be 0 in a planar world");
        CHECK_EQ(dem_wall_surface_velocity_get(world, b, &v), DEM_OK);
        CHECK_NEAR(v.x, 0, 0);
        CHECK_EQ(dem_wall_surface_velocity_set(world, b, at(1, 0, 0)), DEM_OK);
        CHECK_EQ(dem_wall_surface_velocity_get(world, b, &v), DEM_OK);
        CHECK_NEAR(v.x, 1, 1e-6);
        dem_world_destroy(world);
    }
    return test_end();
}
