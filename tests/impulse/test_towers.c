/* The direct solution along towers: on every kind of floor, with weights, friction, impacts and either cone, and beside a
   solver that has none. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const double g = 9.81, dt = 0.01;
static double length(dem_vec3 v) { return sqrt((double)(v.x*v.x + v.y*v.y + v.z*v.z)); }
static dem_world_desc heavy(double slope) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.gravity = at(g*sin(slope), 0, -g*cos(slope));
    desc.response = DEM_RESPONSE_IMPULSES;
    desc.dt = (dem_real)dt;
    desc.ledger = 1;
    return desc;
}
static dem_body pile(dem_world *world, dem_material stuff, dem_shape shape, int count, dem_vec3 from, double high) {
    dem_body top = {0};
    int i;
    for (i = 0; i < count; i++)
        top = dem_body_add(world, stuff, shape, at((double)from.x, (double)from.y, (double)from.z + (i + 0.5)*high),
                           dem_quat_make(1, 0, 0, 0));
    return top;
}
/* m/s, the largest speed of a body relative to v */
static double fastest(const dem_world *world, dem_vec3 v) {
    const dem_bodies all = dem_bodies_get(world);
    double most = 0;
    int i;
    for (i = 0; i < all.count; i++) {
        const dem_real *u = all.velocities + 4*i;
        most = fmax(most, length(dem_vec3_make(u[0] - v.x, u[1] - v.y, u[2] - v.z)));
    }
    return most;
}
static double hair(void) { return DEMI_SINGLE ? 1e-3 : 1e-10; }

/* J, kinetic and potential energy, from any zero */
static double energy(const dem_world *world) {
    const dem_ledger l = dem_ledger_get(world);
    return l.kinetic + l.rotational - l.gravity;
}
/* What towers are built on. */
enum { PLANE, FIXED, MESH, SEAM, LIFT, FLOORS };
static void floor_add(dem_world *world, dem_material stuff, int kind) {
    static dem_real corners[12] = {-9, -9, 0, 9, -9, 0, 9, 9, 0, -9, 9, 0};
    static int32_t triangles[6] = {0, 1, 2, 0, 2, 3};
    if (kind == FIXED) {
        dem_body plate = dem_body_add(world, stuff, scene_box(world, 6, 6, 2), at(0, 0, -1), dem_quat_make(1, 0, 0, 0));
        dem_body_state s = scene_state(world, plate);
        s.fixed = 1;
        dem_body_set(world, plate, &s);
    } else if (kind == MESH) {
        dem_mesh mesh;
        memset(&mesh, 0, sizeof mesh);
        mesh.vertices = corners;
        mesh.vertex_count = 4;
        mesh.triangles = triangles;
        mesh.triangle_count = 2;
        CHECK(dem_wall_mesh_add(world, stuff, &mesh).id);
    } else {
        const dem_wall wall = dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1));
        dem_motion rises = DEM_MOTION;
        rises.kind = DEM_MOTION_TRANSLATING;
        rises.velocity = at(0.1, 0, 0.3);
        rises.ramp = 1;
        if (kind == LIFT) CHECK_EQ(dem_wall_motion_set(world, wall, &rises), DEM_OK);
    }
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("a tower of 50 blocks rests on every kind of floor, with one sweep a step") {
        int kind;
        for (kind = 0; kind < FLOORS; kind++) {
            const dem_vec3 rises = kind == LIFT ? at(0.1, 0, 0.3) : at(0, 0, 0);
            dem_world_desc desc = heavy(0);
            dem_world *world;
            dem_material stuff;
            double sweeps = 0;
            int step;
            if (kind == SEAM) {
                desc.domain = box_of(-2, -2, -1, 2, 2, 60);
                desc.boundary[0] = desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
            }
            world = dem_world_create(&desc);
            stuff = scene_material(world, 0, 0, 0.5, 0);
            floor_add(world, stuff, kind);
            pile(world, stuff, scene_box(world, 1, 1, 1), 50, kind == SEAM ? at(2, 2, 0) : at(0.1, 0, 0), 1);
            CHECK_EQ(dem_world_step(world, 150), DEM_OK);
            for (step = 0; step < 100 && dem_world_step(world, 1) == DEM_OK; step++)
                sweeps += dem_counters_get(world).sweeps;
            CHECK_EQ(step, 100);
            if (kind == FIXED) CHECK(fastest(world, at(0, 0, 0)) < hair());
            else CHECK(fastest(world, rises) < hair());
            CHECK(sweeps <= 100);
            dem_world_destroy(world);
        }
    }
    TEST("a floor bears the weight of a tower, and each block that of those above it") {
        const dem_world_desc desc = heavy(0);
        dem_world *world = dem_world_create(&desc);
        const dem_material stuff = scene_material(world, 0, 0, 0.5, 0);
        const dem_wall wall = dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1));
        const double weight = 2500*g;
        dem_wall_loads loads;
        dem_contact_info contact[64];
        double under[10] = {0};
        int i, count;
        pile(world, stuff, scene_box(world, 1, 1, 1), 10, at(0, 0, 0), 1);
        CHECK_EQ(dem_world_step(world, 100), DEM_OK);
        CHECK_EQ(dem_wall_loads_get(world, wall, &loads), DEM_OK);
        CHECK_REL(-loads.force.z, 10*weight, DEMI_SINGLE ? 1e-4 : 1e-9);
        count = dem_contacts_get(world, contact, 64);
        CHECK_EQ(count, 40);
        for (i = 0; i < count; i++) {
            const dem_contact_info *c = &contact[i];
            const double z = 0.5*((double)scene_state(world, c->a).position.z +
                                  (c->b.slot ? (double)scene_state(world, c->b).position.z : -0.5));
            under[(int)(z + 0.25)] += fabs((double)c->force.z);
        }
        for (i = 0; i < 10; i++) CHECK_REL(under[i], (10 - i)*weight, DEMI_SINGLE ? 1e-4 : 1e-9);
        dem_world_destroy(world);
    }
    TEST("blocks on each other slide together if friction yields at the floor only") {
        const double rate[2] = {4, 6}, mu = 0.5;        /* m/s2; mu g is 4.9 */
        int k;
        for (k = 0; k < 2; k++) {
            dem_world_desc desc = heavy(0);
            dem_world *world;
            dem_material stuff, ice;
            dem_pair pair;
            desc.gravity.x = (dem_real)-rate[k];
            world = dem_world_create(&desc);
            stuff = scene_material(world, 0, 0, 2*mu, 0);
            ice = scene_material(world, 0, 0, mu, 0);
            CHECK_EQ(dem_pair_get(world, stuff, ice, &pair), DEM_OK);
            pair.friction = (dem_real)mu;
            CHECK_EQ(dem_pair_set(world, stuff, ice, &pair), DEM_OK);
            dem_wall_plane_add(world, ice, at(0, 0, 0), at(0, 0, 1));
            pile(world, stuff, scene_box(world, 8, 1, 0.5), 6, at(0, 0, 0), 0.5);
            CHECK_EQ(dem_world_step(world, 50), DEM_OK);
            if (!k) CHECK(fastest(world, at(0, 0, 0)) < hair());
            else CHECK(fastest(world, at(-(rate[k] - mu*g)*50*dt, 0, 0)) < 1e-3);
            dem_world_destroy(world);
        }
    }
    TEST("a tower that topples, bounces or is hit gains no energy, with either cone") {
        enum { TOPPLES, BOUNCES, HIT, WAYS };
        int cone, way, step;
        for (cone = 0; cone < 2; cone++)
            for (way = 0; way < WAYS; way++) {
                dem_world_desc desc = heavy(way == TOPPLES ? 0.2 : 0);
                dem_world *world;
                dem_material stuff;
                double most;
                desc.cone = cone ? DEM_CONE_CONVEX : DEM_CONE_COULOMB;
                world = dem_world_create(&desc);
                stuff = scene_material(world, 0, way == BOUNCES ? 0.7 : 0, 0.8, 0);
                dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1));
                pile(world, stuff, scene_box(world, 1, 1, 1), 8, at(0, 0, way == BOUNCES ? 1 : 0), 1);
                if (way == HIT)
                    scene_move(world, dem_sphere_add(world, stuff, DEM_R(0.5), at(-3, 0.2, 5.2)), at(20, 0, 0),
                               at(0, 0, 0));
                most = energy(world);
                for (step = 0; step < 300 && dem_world_step(world, 1) == DEM_OK; step++) {
                    CHECK(energy(world) < most + 1e-3*8*2500*g);
                    most = fmin(most, energy(world));
                }
                CHECK_EQ(step, 300);
                dem_world_destroy(world);
            }
    }
    TEST("towers give the velocities that sweeps alone give") {
        /* the convex problem has one solution; other solvers have no towers */
        const dem_solver solver[2] = {DEM_SOLVER_GAUSS_SEIDEL, DEM_SOLVER_APGD};
        dem_vec3 v[2][24];
        int k, i;
        for (k = 0; k < 2; k++) {
            dem_world_desc desc = heavy(0.3);
            dem_world *world;
            dem_material stuff;
            uint64_t seed = 5;
            desc.cone = DEM_CONE_CONVEX;
            desc.solver = solver[k];
            desc.tolerance = DEMI_SINGLE ? DEM_R(1e-5) : DEM_R(1e-9);
            desc.sweeps = 100000;
            world = dem_world_create(&desc);
            stuff = scene_material(world, 0, 0, 0.6, 0);
            dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1));
            pile(world, stuff, scene_box(world, 1, 1, 1), 12, at(0, 0, 0), 1);
            pile(world, stuff, scene_box(world, 1, 1, 1), 12, at(1, 0.1, 0), 1);
            for (i = 0; i < 24; i++) {
                const dem_body body = dem_body_id_get(world, i);
                scene_move(world, body, scene_at(&seed, 2e-2, -1e-2, 2e-2, -1e-2, 2e-2, -1e-2), at(0, 0, 0));
            }
            CHECK_EQ(dem_world_step(world, 1), DEM_OK);
            CHECK_EQ(dem_counters_get(world).unsolved, 0);
            for (i = 0; i < 24; i++) v[k][i] = scene_state(world, dem_body_id_get(world, i)).velocity;
            dem_world_destroy(world);
        }
        for (i = 0; i < 24; i++)
            CHECK_NEAR(length(dem_vec3_make(v[0][i].x - v[1][i].x, v[0][i].y - v[1][i].y, v[0][i].z - v[1][i].z)), 0,
                       DEMI_SINGLE ? 1e-3 : 1e-6);
    }
    TEST("the world refuses a step in which polyhedra would not rest and names one in which they do") {
        /* 0.15 sqrt(edge/g) = 0.0479 s for cubes of 1 m; spheres have no limit */
        dem_world_desc desc = heavy(0);
        dem_advice advice;
        int kind;
        desc.dt = DEM_R(0.05);
        for (kind = 0; kind < 3; kind++) {
            dem_world *world;
            dem_material stuff;
            desc.allow_large_dt = kind == 1;
            world = dem_world_create(&desc);
            stuff = scene_material(world, 0, 0, 0.5, 0);
            dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1));
            dem_sphere_add(world, stuff, DEM_R(0.1), at(3, 0, 0.1));
            if (kind < 2) pile(world, stuff, scene_box(world, 1, 1, 1), 2, at(0, 0, 0), 1);
            CHECK_EQ(dem_world_step(world, 1), kind ? DEM_OK : DEM_ERROR_TIME_STEP);
            if (!kind) CHECK_STR(dem_world_error_get(world), "must be at most 0.0479 s for polyhedra");
            CHECK_EQ(dem_step_advice_get(world, &advice), DEM_ERROR_ARGUMENT);
            if (kind < 2) CHECK_STR(dem_world_error_get(world), "at most 0.032 s");
#ifndef DEM_NO_REPORTS
            if (kind < 2) {
                dem_finding f[8];
                int i, found = dem_world_check(world, f, 8);
                for (i = 0; i < found && !strstr(f[i].text, "for polyhedra as small as these to rest"); i++) continue;
                CHECK(i < found && f[i].severity == (kind ? DEM_SEVERITY_WARNING : DEM_SEVERITY_ERROR));
            }
#endif
            dem_world_destroy(world);
        }
    }
    return test_end();
}
