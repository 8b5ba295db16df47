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
/* Height above a floor after 40 steps, m, of a grain that falls on it; both move up at `lift`, m/s. The grain is added
   after `wait` steps. */
static double frames_bounce(double lift, int wait) {
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
    CHECK(dem_world_step(w, wait) == DEM_OK);
    grain = dem_sphere_add(w, m, DEM_R(1e-3), at(0, 0, lift*dem_world_time_get(w) + 1e-3 + ldexp(1, -16)));
    scene_move(w, grain, at(0.1, 0, lift - ldexp(1, -5)), at(0, 0, 0));
    CHECK(dem_world_step(w, 40) == DEM_OK);
    high = (double)scene_state(w, grain).position.z - lift*dem_world_time_get(w);
    dem_world_destroy(w);
    return high;
}
/* Sets v[0..2] to the velocity, m/s, relative to the frame, after two steps of a grain that is set at the edge of a
   hole (kind 0), within a cylinder (1) or at the edge of a mesh (2). The frame moves at `lift` times (2, -1, 4) m/s. */
static void frames_edge(int kind, double lift, double *v) {
    static dem_real corners[] = {0, 0, 0, DEM_R(-0.02), 0, 0, DEM_R(-0.02), DEM_R(0.02), 0, 0, DEM_R(0.02), 0};
    static int32_t facets[] = {0, 1, 2, 0, 2, 3};
    static const double x[3][3] = {{-1e-3, 0, 0.2e-3}, {3.95e-3, 1e-3, 0}, {0.3e-3, 0.01, 0.9e-3}};
    dem_world *w = frames_world(at(0, 0, 0), 2e-4);
    const dem_material m = scene_material(w, 1e7, 0.5, 0.3, 0);
    dem_sieve_desc sieve = DEM_SIEVE_DESC;
    dem_motion along = DEM_MOTION;
    dem_mesh mesh;
    dem_body grain;
    dem_wall wall;
    mesh.vertex_count = 4;
    mesh.triangle_count = 2;
    mesh.vertices = corners;
    mesh.triangles = facets;
    sieve.kind = DEM_SIEVE_ROUND;
    sieve.aperture = DEM_R(1.7e-3);
    sieve.bar = DEM_R(0.9e-3);
    wall = kind == 0 ? dem_wall_sieve_add(w, m, &sieve)
        : kind == 1 ? dem_wall_cylinder_add(w, m, at(0, 0, 0), at(0, 0, 1), DEM_R(5e-3), 1)
        : dem_wall_mesh_add(w, m, &mesh);
    along.kind = DEM_MOTION_TRANSLATING;
    along.velocity = at(2*lift, -lift, 4*lift);
    dem_wall_motion_set(w, wall, &along);
    grain = dem_sphere_add(w, m, DEM_R(1e-3), at(x[kind][0], x[kind][1], x[kind][2]));
    scene_move(w, grain, at((kind == 1 ? 1 : -1) + 2*lift, 0.2 - lift, -0.5 + 4*lift), at(0, 0, 0));
    CHECK(dem_world_step(w, 2) == DEM_OK);
    v[0] = (double)scene_state(w, grain).velocity.x - 2*lift;
    v[1] = (double)scene_state(w, grain).velocity.y + lift;
    v[2] = (double)scene_state(w, grain).velocity.z - 4*lift;
    dem_world_destroy(w);
}
/* Velocity, m/s, relative to the frame, of a grain that has been under way for seven steps when another is added, which
   hits it; the frame moves at `lift`, m/s. */
static double frames_met(double lift) {
    dem_world *w = frames_world(at(0, 0, 0), ldexp(1, -12));
    const dem_material m = scene_material(w, 1e7, 0.7, 0.3, 0);
    const dem_body grain = dem_sphere_add(w, m, DEM_R(1e-3), at(0, 0, 0));
    dem_body other;
    double v;
    scene_move(w, grain, at(0, 0, lift), at(0, 0, 0));
    CHECK(dem_world_step(w, 7) == DEM_OK);
    other = dem_sphere_add(w, m, DEM_R(1e-3), at(1e-4, 0, lift*dem_world_time_get(w) + 2e-3 + ldexp(1, -15)));
    scene_move(w, other, at(0, 0, lift - ldexp(1, -4)), at(0, 0, 0));
    CHECK(dem_world_step(w, 4) == DEM_OK);
    v = (double)scene_state(w, grain).velocity.z - lift;
    CHECK(v < -1e-3);
    dem_world_destroy(w);
    return v;
}
/* Velocity, m/s, relative to the frame, of a body that is under way when a grain is set beside it, which hits it in the
   next step; the frame moves at `across`, m/s, along the contact. kind 0: a grain; 1: an ellipsoid; 2: a cube. */
static dem_vec3 frames_struck(int kind, double across) {
    dem_world *w = frames_world(at(0, 0, 0), ldexp(1, -12));
    const dem_material m = scene_material(w, 1e7, 0.7, 0.3, 0);
    const dem_real a = DEM_R(1e-3);
    dem_real points[24];
    dem_body body, other;
    dem_vec3 v;
    int i, k;
    for (i = 0; i < 8; i++) for (k = 0; k < 3; k++) points[3*i + k] = i >> k & 1 ? a : -a;
    body = !kind ? dem_sphere_add(w, m, a, at(0, 0, 0)) : dem_body_add(w, m, kind == 1
        ? dem_shape_ellipsoid_add(w, at(2e-3, 1.5e-3, 1e-3)) : dem_shape_polyhedron_add(w, 8, points),
        at(0, 0, 0), dem_quat_make(1, 0, 0, 0));
    scene_move(w, body, at(across, 0, 0), at(0, 0, 0));
    CHECK(dem_world_step(w, 7) == DEM_OK);
    other = dem_sphere_add(w, m, a, at(across*dem_world_time_get(w) + 2e-4, 0, 2e-3));
    scene_move(w, other, at(across, 0, -0.25), at(0, 0, 0));
    CHECK(dem_world_step(w, 1) == DEM_OK);
    v = scene_state(w, body).velocity;
    v.x -= (dem_real)across;
    CHECK(v.z < -0.01);
    dem_world_destroy(w);
    return v;
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

/* Distance, m, of a cube and a larger ball that overlap by 1e-5 m, after a step; the ball is added first, or last, and
   is above the cube, or (up -1) below. */
static double frames_parted(int ball_first, double up) {
    dem_world *w = frames_world(at(0, 0, 0), 2.5e-4);
    const dem_material m = scene_material(w, 1e7, 0.5, 0, 0);
    dem_real points[24];
    dem_body cube = {0}, ball = {0};
    dem_shape shape;
    double apart;
    int i, k;
    for (i = 0; i < 8; i++) for (k = 0; k < 3; k++) points[3*i + k] = (dem_real)(i >> k & 1 ? 5e-4 : -5e-4);
    shape = dem_shape_polyhedron_add(w, 8, points);
    for (i = 0; i < 2; i++)
        if (i == ball_first) cube = dem_body_add(w, m, shape, at(0, 0, 0), dem_quat_make(1, 0, 0, 0));
        else ball = dem_sphere_add(w, m, DEM_R(2e-3), at(0, 0, up*(2.5e-3 - 1e-5)));
    CHECK(dem_world_step(w, 1) == DEM_OK);
    apart = up*(double)(scene_state(w, ball).position.z - scene_state(w, cube).position.z);
    dem_world_destroy(w);
    return apart;
}
/* Largest asymmetry, m, of a row of seven grains after a step; each overlaps its neighbours by 1e-5 m. */
static double frames_row(void) {
    dem_world *w = frames_world(at(0, 0, 0), 2.5e-4);
    const dem_material m = scene_material(w, 1e7, 0.5, 0, 0);
    dem_body row[7];
    double off = 0;
    int i;
    for (i = 0; i < 7; i++) row[i] = dem_sphere_add(w, m, DEM_R(1e-3), at((i - 3)*1.99e-3, 0, 0));
    CHECK(dem_world_step(w, 1) == DEM_OK);
    for (i = 0; i < 3; i++)
        off = fmax(off, fabs((double)(scene_state(w, row[i]).position.x + scene_state(w, row[6 - i]).position.x)));
    dem_world_destroy(w);
    return off;
}
/* Velocity, m/s, after a step of a grain that overlaps a compliant floor, from which it moves at `up`, m/s. Another grain
   passes at 1 m/s. */
static double frames_soft(double up) {
    dem_world *w = frames_world(at(0, 0, 0), 2.5e-4);
    const dem_material m = scene_material(w, 1e7, 0.5, 0, 0);
    dem_pair pair;
    dem_body grain, other;
    double v;
    dem_pair_get(w, m, m, &pair);
    pair.compliance = DEM_R(1e-3);
    dem_pair_set(w, m, m, &pair);
    dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1));
    grain = dem_sphere_add(w, m, DEM_R(1e-3), at(0, 0, 1e-3 - 1e-5));
    other = dem_sphere_add(w, m, DEM_R(1e-3), at(0.1, 0, 0.1));
    scene_move(w, other, at(1, 0, 0), at(0, 0, 0));
    scene_move(w, grain, at(0, 0, up), at(0, 0, 0));
    CHECK(dem_world_step(w, 2) == DEM_OK);
    v = (double)scene_state(w, grain).velocity.z;
    dem_world_destroy(w);
    return v;
}
/* Velocity, m/s, after ten steps of a grain that moves at 0.4 m/s and would reach a wall at x after 10.5 steps: where
   contacts are detected, half a step ahead, it reaches the wall exactly at the end of a step. */
static double frames_exactly(double x) {
    dem_world *w = frames_world(at(0, 0, 0), 2e-4);
    const dem_material m = scene_material(w, 1e7, 0.5, 0, 0);
    dem_body grain;
    double v;
    dem_wall_plane_add(w, m, at(x, 0, 0), at(-1, 0, 0));
    grain = dem_sphere_add(w, m, DEM_R(1e-3), at(x - 1e-3 - 10.5*8e-5, 0, 0));
    scene_move(w, grain, at(0.4, 0, 0), at(0, 0, 0));
    CHECK(dem_world_step(w, 10) == DEM_OK);
    v = (double)scene_state(w, grain).velocity.x;
    dem_world_destroy(w);
    return v;
}
/* Velocity, m/s, of a rock that has hit a wall with several corners, one after another; way -1: the mirror image. */
static dem_vec3 frames_rock(double way) {
    static const double corners[15] = {-6e-4, -6e-4, 0, 0, 0, -6e-4, -6e-4, 6e-4, -6e-4, 0, -6e-4, 0, 6e-4, 0, 0};
    dem_world *w = frames_world(at(0, 0, 0), 3e-4);
    const dem_material m = scene_material(w, 1e7, 0, 0, 0);
    const dem_real turn[4] = {0, 0, 0, (dem_real)way}, size = 1;
    const dem_vec3 x = at(0, -6e-3*way, 0), v = at(0, -0.4*way, 0), spin = at(0, 0, 0);
    dem_real points[15];
    dem_vec3 after;
    int i;
    for (i = 0; i < 15; i++) points[i] = (dem_real)(corners[i]*(i%3 == 1 ? way : 1));
    dem_wall_plane_add(w, m, at(0, -7e-3*way, 0), at(0, way, 0));
    CHECK(dem_bodies_add(w, m, dem_shape_polyhedron_add(w, 5, points), 1, &x.x, turn, &v.x, &spin.x, &size) == DEM_OK);
    CHECK(dem_world_step(w, 5) == DEM_OK);
    after = scene_state(w, dem_body_id_get(w, 0)).velocity;
    after.y *= (dem_real)way;
    dem_world_destroy(w);
    return after;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("a grain bounces on a floor that moves along with it as on one at rest, from the first step") {
        const double still = frames_bounce(0, 0);
        const double eps = DEMI_SINGLE ? 1e-7 : 1e-15;     /* m: round-off of positions, 40 steps */
        CHECK_NEAR(frames_bounce(0.25, 0), still, eps);
        CHECK_NEAR(frames_bounce(-0.25, 0), still, eps);
        CHECK_NEAR(frames_bounce(0.5, 0), still, eps);
    }
    TEST("a grain that is added later bounces on a moving floor as on one at rest") {
        const double still = frames_bounce(0, 7);
        const double eps = DEMI_SINGLE ? 1e-7 : 1e-15;
        CHECK_NEAR(still, frames_bounce(0, 0), eps);
        CHECK_NEAR(frames_bounce(0.25, 7), still, eps);
        CHECK_NEAR(frames_bounce(-0.25, 7), still, eps);
        CHECK_NEAR(frames_bounce(0.5, 7), still, eps);
    }
    TEST("a grain that is set at an edge or a curved wall hits it as in a frame that moves along") {
        double still[3], moved[3];
        int kind, k;
        for (kind = 0; kind < 3; kind++) {
            frames_edge(kind, 0, still);
            frames_edge(kind, 0.0625, moved);
            CHECK(fabs(still[0] - (kind == 1 ? 1 : -1)) > 0.01);     /* it has hit */
            for (k = 0; k < 3; k++) CHECK_NEAR(moved[k], still[k], DEMI_SINGLE ? 1e-4 : 1e-8);
        }
    }
    TEST("a grain that is added beside others hits one of them as in a frame that moves along") {
        const double eps = DEMI_SINGLE ? 1e-6 : 1e-12;     /* m/s */
        CHECK_NEAR(frames_met(0.25), frames_met(0), eps);
        CHECK_NEAR(frames_met(-0.5), frames_met(0), eps);
    }
    TEST("a grain that is set against a moving body strikes it alike in every frame of reference") {
        const double eps = DEMI_SINGLE ? 1e-5 : 1e-8;      /* m/s: ten tolerances */
        int kind;
        for (kind = 0; kind < 3; kind++) {
            const dem_vec3 still = frames_struck(kind, 0), moved = frames_struck(kind, 0.5);
            CHECK_NEAR(moved.x, still.x, eps);
            CHECK_NEAR(moved.z, still.z, eps);
        }
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
    TEST("an overlap of bodies of different size is corrected alike, whichever was added first") {
        const double eps = DEMI_SINGLE ? 1e-9 : 1e-15;     /* m: round-off of positions */
        CHECK_NEAR(frames_parted(1, 1), frames_parted(0, 1), eps);
        CHECK_NEAR(frames_parted(0, -1), frames_parted(0, 1), eps);
        CHECK_NEAR(frames_parted(1, -1), frames_parted(0, 1), eps);
    }
    TEST("overlaps in a row of grains are corrected symmetrically, to the tolerance") {
        CHECK(frames_row() < (DEMI_SINGLE ? 1e-8 : 1e-11));        /* m: 40 tolerances times dt */
    }
    TEST("a speed of round-off is no impact on a compliant floor") {
        const double still = frames_soft(0);
        CHECK(still > 1e-3);                    /* m/s: the spring pushes it out */
        CHECK_NEAR(frames_soft(-1e-18), still, 1e-9);
        CHECK_NEAR(frames_soft(1e-18), still, 1e-9);
    }
    TEST("an impact at the end of a step happens in the same step wherever the wall is") {
        int i, k;
        for (i = k = 0; i < 40; i++) k += frames_exactly(0.0137*i) < 0;
        CHECK(k == 0 || k == 40);
        if (k != 0 && k != 40) printf("    %d of 40 have bounced\n", k);
    }
    TEST("a rock that hits a wall with one corner after another moves as its mirror image") {
        const dem_vec3 a = frames_rock(1), b = frames_rock(-1);
        const double eps = DEMI_SINGLE ? 1e-3 : 1e-6;       /* m/s: 1000 tolerances */
        CHECK_NEAR(b.x, a.x, eps);
        CHECK_NEAR(b.y, a.y, eps);
        CHECK_NEAR(b.z, a.z, eps);
    }
    return test_end();
}
