/* Impulses in other frames of reference and other units, and decisions that round-off must not take (>>impulses,
   >>joints). */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static dem_world *frames_world(dem_vec3 gravity, double dt) {
    dem_world_desc d = DEM_WORLD_DESC;
    d.response = DEM_RESPONSE_IMPULSES;
    d.gravity = gravity;
    d.dt = (dem_real)dt;
    d.tolerance = DEM_R(1e-9);
    d.sweeps = 2000;
    d.orientations = 1;
    return dem_world_create(&d);
}
/* Height above a floor after 40 steps, m, of a grain that falls on it; both move up at `lift`, m/s. */
static double frames_bounce(double lift) {
    dem_world *w = frames_world(at(0, 0, 0), ldexp(1, -12));
    const dem_material m = scene_material(w, 1e7, 0.7, 0.3, 0);
    dem_motion up = DEM_MOTION;
    dem_wall floor;
    dem_body grain;
    double high;
    floor = dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1));
    up.kind = DEM_MOTION_TRANSLATING;
    up.velocity = at(0, 0, lift);
    dem_wall_motion_set(w, floor, &up);
    grain = dem_sphere_add(w, m, DEM_R(1e-3), at(0, 0, 1e-3 + ldexp(1, -16)));
    scene_move(w, grain, at(0.1, 0, lift - ldexp(1, -5)), at(0, 0, 0));
    CHECK(dem_world_step(w, 40) == DEM_OK);
    high = (double)scene_state(w, grain).position.z - lift*dem_world_time_get(w);
    dem_world_destroy(w);
    return high;
}
/* Velocity, m/s, of a grain that has slid on a floor at height z, one step after the floor is set in motion at
   0.02 m/s. */
static double frames_lifted(double z) {
    dem_world *w = frames_world(at(0, 0, -9.81), 2.58e-4);
    const dem_material m = scene_material(w, 1e7, 0.5, 0.3, 0);
    dem_motion up = DEM_MOTION;
    dem_wall floor;
    dem_body grain;
    double v;
    floor = dem_wall_plane_add(w, m, at(0, 0, z), at(0, 0, 1));
    grain = dem_sphere_add(w, m, DEM_R(1e-3), at(0, 0, z + 1e-3));
    scene_move(w, grain, at(0.1, 0.02, 0), at(0, 0, 0));
    CHECK(dem_world_step(w, 20) == DEM_OK);
    up.kind = DEM_MOTION_TRANSLATING;
    up.velocity = at(0, 0, 0.02);
    dem_wall_motion_set(w, floor, &up);
    CHECK(dem_world_step(w, 1) == DEM_OK);
    v = (double)scene_state(w, grain).velocity.z;
    dem_world_destroy(w);
    return v;
}
/* Two cubes on a hinge fall on a floor; their velocities after the given number of steps. */
static void frames_hinge(double tolerance, int steps, double *v) {
    dem_world_desc d = DEM_WORLD_DESC;
    dem_joint_desc hinge = DEM_JOINT_DESC;
    dem_real points[24];
    dem_body cubes[2];
    dem_material m;
    dem_shape cube;
    dem_world *w;
    int i, k;
    d.response = DEM_RESPONSE_IMPULSES;
    d.gravity = at(0, 0, -9.81);
    d.dt = DEM_R(2.5e-4);
    d.tolerance = (dem_real)tolerance;
    d.sweeps = 20000;
    w = dem_world_create(&d);
    m = scene_material(w, 1e7, 0, 0, 0);
    dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1));
    for (i = 0; i < 8; i++) for (k = 0; k < 3; k++) points[3*i + k] = (dem_real)(i >> k & 1 ? 5e-4 : -5e-4);
    cube = dem_shape_polyhedron_add(w, 8, points);
    for (i = 0; i < 2; i++) {
        const dem_vec3 x = at(2e-3*i, 0, 9e-4 + 1e-4*i), velocity = at(0, 0, -0.2), spin = at(5, 7, 3);
        const dem_real turn[4] = {DEM_R(0.9), DEM_R(0.3), (dem_real)(0.2*i), DEM_R(0.1)}, size = 1;
        dem_bodies_add(w, m, cube, 1, &x.x, turn, &velocity.x, &spin.x, &size);
        cubes[i] = dem_body_id_get(w, i);
    }
    hinge.kind = DEM_JOINT_REVOLUTE;
    hinge.a = cubes[0];
    hinge.b = cubes[1];
    hinge.point = at(1e-3, 0, 1e-3);
    hinge.axis = at(0, 1, 0);
    dem_joint_add(w, &hinge);
    CHECK(dem_world_step(w, steps) == DEM_OK);
    CHECK(dem_counters_get(w).unsolved == 0);
    for (i = 0; i < 2; i++) {
        const dem_body_state s = scene_state(w, cubes[i]);
        v[3*i] = (double)s.velocity.x; v[3*i + 1] = (double)s.velocity.y; v[3*i + 2] = (double)s.velocity.z;
    }
    dem_world_destroy(w);
}
/* Six grains in a drum, two of them on a hinge, thrown at random. Returns the position of one of these after 20 steps,
   relative to the floor at height z. */
static dem_vec3 frames_drum(uint64_t seed, double z) {
    dem_world *w = frames_world(at(0, 0, -9.81), 4e-4);
    const dem_material m = scene_material(w, 1e7, 0.5, 0.3, 0);
    dem_joint_desc hinge = DEM_JOINT_DESC;
    dem_body grains[6];
    dem_vec3 x;
    int i;
    dem_wall_plane_add(w, m, at(0, 0, z), at(0, 0, 1));
    dem_wall_cylinder_add(w, m, at(0, 0, z), at(0, 0, 1), DEM_R(6e-3), 1);
    for (i = 0; i < 6; i++) {
        const dem_vec3 v = scene_at(&seed, 0.6, -0.3, 0.6, -0.3, 0.6, -0.3);
        grains[i] = dem_sphere_add(w, m, DEM_R(1e-3), at(3e-3*(i%3 - 1), 3e-3*(i/3) - 1.5e-3, z + 1.1e-3));
        scene_move(w, grains[i], v, scene_at(&seed, 80, -40, 80, -40, 80, -40));
    }
    hinge.kind = DEM_JOINT_REVOLUTE;
    hinge.a = grains[0];
    hinge.b = grains[4];
    hinge.point = at(-2.5e-3, -1.5e-3, z + 1.1e-3);
    hinge.axis = at(0, 0, 1);
    dem_joint_add(w, &hinge);
    CHECK(dem_world_step(w, 20) == DEM_OK);
    x = scene_state(w, grains[0]).position;
    dem_world_destroy(w);
    x.z -= (dem_real)z;
    return x;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("a grain bounces on a floor that moves along with it as on one at rest, from the first step") {
        const double still = frames_bounce(0);
        const double eps = DEMI_SINGLE ? 1e-7 : 1e-15;     /* m: round-off of positions, 40 steps */
        CHECK_NEAR(frames_bounce(0.25), still, eps);
        CHECK_NEAR(frames_bounce(-0.25), still, eps);
        CHECK_NEAR(frames_bounce(0.5), still, eps);
    }
    TEST("a floor that starts to move throws up a resting grain whatever its round-off") {
        double least = 1, most = 0;
        int k;
        for (k = 0; k < 40; k++) {
            const double v = frames_lifted(k*0.0137);
            least = fmin(least, v);
            most = fmax(most, v);
        }
        CHECK_NEAR(most, least, 1e-5);         /* m/s; restitution makes it 0.01 */
        if (!(most - least < 1e-5)) printf("    from %g to %g m/s\n", least, most);
    }
    TEST("contacts of joined cubes are solved to the tolerance") {
        double rough[6], fine[6], off = 0;
        int steps, k;
        for (steps = 1; steps < 30 && !DEMI_SINGLE; steps++) {      /* float cannot reach this tolerance */
            frames_hinge(1e-9, steps, rough);
            frames_hinge(1e-11, steps, fine);
            for (k = 0; k < 6; k++) off = fmax(off, fabs(rough[k] - fine[k]));
        }
        CHECK(off < 1e-6);                     /* m/s: 1000 tolerances */
    }
    TEST("round-off does not decide whether the gap of a hinge is closed") {
        const double few = DEMI_SINGLE ? 1e-4 : 1e-12;     /* m: what round-off grows to in 20 steps */
        uint64_t seed;
        for (seed = 1; seed <= 40; seed++) {
            const dem_vec3 x = frames_drum(seed, 0), y = frames_drum(seed, 0.137);
            CHECK_NEAR(y.x, x.x, few);
            CHECK_NEAR(y.y, x.y, few);
            CHECK_NEAR(y.z, x.z, few);
        }
    }
    return test_end();
}
