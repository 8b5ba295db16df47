/* Walls that move: ramps and tables. A pose's velocity and spin are the derivatives of its place and rotation, or else
   grains would be pushed by what is not there. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const int fine = sizeof(dem_real) == 8;       /* double precision */

static dem_world *stage(dem_wall *wall, double dt) {
    static const dem_real corners[] = {1, 2, 0, 2, 2, 0, 1, 3, DEM_R(0.5)};
    static const int32_t triangle[] = {0, 1, 2};
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material m;
    dem_mesh mesh;
    desc.dt = (dem_real)dt;
    desc.allow_large_dt = 1;
    world = dem_world_create(&desc);
    m = scene_material(world, 1e6, 0.9, 0.5, 0);
    dem_sphere_add(world, m, DEM_R(0.01), at(-5, 0, 0));
    mesh.vertex_count = 3;
    mesh.triangle_count = 1;
    mesh.vertices = (dem_real *)corners;
    mesh.triangles = (int32_t *)triangle;
    *wall = dem_wall_mesh_add(world, m, &mesh);
    return world;
}
/* Steps; the largest difference of the told velocity and spin from the difference of poses two steps apart, over the
   largest told ones. Spin from the rotation's derivative: dR/dt R^T. */
static double derivative_off(dem_world *world, dem_wall wall, double dt, int steps, double *fastest) {
    dem_pose p[3];
    double off = 0, most = 1e-12, before = 0;
    int k, i, j;
    for (k = 0; k < 3; k++) { CHECK_EQ(scene_step(world, 1), DEM_OK); dem_wall_pose_get(world, wall, &p[k]); }
    for (k = 0; k < steps; k++) {
        const double x[3] = {(double)(p[2].position.x - p[0].position.x), (double)(p[2].position.y - p[0].position.y),
                             (double)(p[2].position.z - p[0].position.z)};
        const double v[3] = {(double)p[1].velocity.x, (double)p[1].velocity.y, (double)p[1].velocity.z};
        const double s[3] = {(double)p[1].spin.x, (double)p[1].spin.y, (double)p[1].spin.z};
        double W[9], w[3];
        for (i = 0; i < 3; i++)
            for (j = 0; j < 3; j++) {
                int e;
                W[3*i + j] = 0;
                for (e = 0; e < 3; e++)
                    W[3*i + j] += (double)(p[2].rotation[3*i + e] - p[0].rotation[3*i + e])/(2*dt)*(double)p[1].rotation[3*j + e];
            }
        w[0] = (W[7] - W[5])/2; w[1] = (W[2] - W[6])/2; w[2] = (W[3] - W[1])/2;
        for (i = 0; i < 3; i++) {
            off = fmax(off, fmax(fabs(x[i]/(2*dt) - v[i]), fabs(w[i] - s[i])));
            most = fmax(most, fmax(fabs(v[i]), fabs(s[i])));
        }
        p[0] = p[1];
        p[1] = p[2];
        CHECK_EQ(scene_step(world, 1), DEM_OK);
        dem_wall_pose_get(world, wall, &p[2]);
        /* no jumps of velocity: what a step changes is small beside all of it */
        before = fmax(before, fabs((double)(p[2].velocity.x - p[1].velocity.x)) + fabs((double)(p[2].spin.z - p[1].spin.z)));
    }
    if (fastest) *fastest = most;
    CHECK(before < 0.05*most);
    return off/most;
}
static dem_motion_row row(double t, dem_vec3 x, double angle) {
    dem_motion_row r;
    r.time = t;
    r.position = x;
    r.rotation = dem_quat_make((dem_real)cos(angle/2), 0, 0, (dem_real)sin(angle/2));
    return r;
}

static void jumps(double time, dem_pose *pose, void *user) {
    (void)time;
    (void)user;
    pose->position.z += DEM_R(0.033);
}

int main(int argc, char **argv) {
    const double near_by = fine ? 2e-4 : 0.05;       /* differences of two steps of 1/500 of the motion */
    test_begin(argc, argv);

    TEST("a ramp starts a wall smoothly, with velocity and spin as the pose's derivatives, and lags by half a ramp "
         "for ever") {
        int kind;
        for (kind = DEM_MOTION_TRANSLATING; kind <= DEM_MOTION_OSCILLATING; kind++) {
            dem_wall wall;
            dem_world *world = stage(&wall, 2e-3);
            dem_motion m = DEM_MOTION;
            dem_pose p;
            double fastest;
            m.kind = (dem_motion_kind)kind;
            m.velocity = at(0.3, 0, 0.4);
            m.axis = at(0, 1, 2);
            m.point = at(1, 0, 0);
            m.speed = 2;
            m.amplitude = DEM_R(0.1);
            m.frequency = 1;
            m.ramp = 0.5;
            CHECK_EQ(dem_wall_motion_set(world, wall, &m), DEM_OK);
            CHECK(derivative_off(world, wall, 2e-3, 500, &fastest) < near_by);
            CHECK_EQ(dem_world_run_to(world, 2, 0, 0), DEM_OK);
            dem_wall_pose_get(world, wall, &p);
            if (kind == DEM_MOTION_TRANSLATING) {
                CHECK_NEAR(p.position.x, 0.3*(2 - 0.25), 1e-3);
                CHECK_REL(fastest, 0.4, 1e-6);
            }
            if (kind == DEM_MOTION_ROTATING) {
                CHECK_REL(fastest, 2*2/sqrt(5.0), 0.3);     /* spin about y + 2 z, or the place's speed */
                /* turned by 2 (2 - 1/4) rad: the trace says so */
                CHECK_NEAR((double)(p.rotation[0] + p.rotation[4] + p.rotation[8]), 1 + 2*cos(3.5), 1e-2);
            }
            m.ramp = -1;
            CHECK_EQ(dem_wall_motion_set(world, wall, &m), DEM_ERROR_ARGUMENT);
            CHECK_STR(dem_world_error_get(world), "ramp of wall 1 is -1 s, must be >= 0 s");
            dem_world_destroy(world);
        }
    }

    TEST("a table's poses are reached on time from rest to rest, with velocities as their derivatives; the table is "
         "copied") {
        dem_wall wall;
        dem_world *world = stage(&wall, 2e-3);
        dem_motion m = DEM_MOTION;
        dem_motion_row rows[5], told[5];
        dem_pose p;
        size_t memory;
        int k;
        rows[0] = row(0, at(0, 0, 0), 0);
        rows[1] = row(0.3, at(0.1, 0, 0), 1);
        rows[2] = row(0.5, at(0.1, 0.2, 0), 2.5);
        rows[3] = row(1.1, at(0, 0.2, 0.1), 4);          /* further than half a turn in all */
        rows[4] = row(1.5, at(0, 0.2, 0.1), 4);
        memcpy(told, rows, sizeof told);
        m.kind = DEM_MOTION_TABLE;
        m.table = rows;
        m.table_count = 5;
        m.point = at(1, 2, 0);
        CHECK_EQ(dem_wall_motion_set(world, wall, &m), DEM_OK);
        memset(rows, 0, sizeof rows);
        dem_world_destroy(world);
        /* at a row the acceleration jumps, and with it the difference of two steps by a quarter of that */
        world = stage(&wall, 1e-4);
        m.table = told;
        CHECK_EQ(dem_wall_motion_set(world, wall, &m), DEM_OK);
        CHECK(derivative_off(world, wall, 1e-4, 15000, 0) < (fine ? 2e-3 : 0.1));
        dem_world_destroy(world);
        world = stage(&wall, 2e-3);
        m.table = told;
        CHECK_EQ(dem_wall_motion_set(world, wall, &m), DEM_OK);
        for (k = 1; k < 5; k++) {
            /* the corner that the wall turns about, and the one beside it */
            const double c = cos(k < 3 ? (k == 1 ? 1 : 2.5) : 4), s = sin(k < 3 ? (k == 1 ? 1 : 2.5) : 4);
            CHECK_EQ(dem_world_run_to(world, told[k].time, 0, 0), DEM_OK);
            dem_wall_pose_get(world, wall, &p);
            CHECK_NEAR(p.rotation[0], c, 5e-3);
            CHECK_NEAR(p.rotation[3], s, 5e-3);
            CHECK_NEAR(p.position.x + p.rotation[0] + 2*p.rotation[1], 1 + (double)told[k].position.x, 2e-3);
            CHECK_NEAR(p.position.y + p.rotation[3] + 2*p.rotation[4], 2 + (double)told[k].position.y, 2e-3);
        }
        CHECK_EQ(dem_world_run_to(world, 3, 0, 0), DEM_OK);
        dem_wall_pose_get(world, wall, &p);
        CHECK_NEAR(demi_length(p.velocity) + demi_length(p.spin), 0, 1e-12);
        /* given anew, again and again, it takes no more memory */
        memory = dem_counters_get(world).memory;
        for (k = 0; k < 100; k++) CHECK_EQ(dem_wall_motion_set(world, wall, &m), DEM_OK);
        CHECK_EQ(dem_counters_get(world).memory, memory);
        CHECK_EQ(dem_wall_remove(world, wall), DEM_OK);
        dem_world_destroy(world);
    }

    TEST("a repeating table runs without stopping through full turns and resumes from a checkpoint with the same "
         "bits") {
        dem_wall wall, other;
        dem_world *world = stage(&wall, 1e-3), *copy = stage(&other, 1e-3);
        dem_motion m = DEM_MOTION;
        dem_motion_row rows[5];
        dem_pose p;
        dem_effect effects[DEM_EFFECTS];
        int k;
        for (k = 0; k < 5; k++) rows[k] = row(0.25*k, at(0.1*sin(k*acos(-1.0)/2), 0, 0), k*acos(-1.0)/2);
        m.kind = DEM_MOTION_TABLE;
        m.table = rows;
        m.table_count = 5;
        m.table_repeats = 1;
        CHECK_EQ(dem_wall_motion_set(world, wall, &m), DEM_OK);
        CHECK_EQ(dem_wall_motion_set(copy, other, &m), DEM_OK);
        CHECK(derivative_off(world, wall, 1e-3, 2200, 0) < (fine ? 4e-3 : 0.1));
        dem_wall_pose_get(world, wall, &p);
        CHECK_REL(p.spin.z, 2*acos(-1.0), 0.1);          /* a turn a second, nearly evenly */
        CHECK_EQ(dem_checkpoint_write(world, "build/tmp/motion.ckpt"), DEM_OK);
        CHECK_EQ(dem_checkpoint_read(copy, "build/tmp/motion.ckpt"), DEM_OK);
        CHECK_EQ(scene_step(world, 333), DEM_OK);
        CHECK_EQ(scene_step(copy, 333), DEM_OK);
        CHECK(dem_world_hash_get(world) == dem_world_hash_get(copy));
        CHECK(dem_effects_get(copy, 0.05, effects) > 0);  /* copies of the world leave its table alone */
        CHECK_EQ(scene_step(copy, 1), DEM_OK);
        dem_world_destroy(world);
        dem_world_destroy(copy);
    }

    TEST("wall and motion costs are measured on copies with all mesh features, and change no bit of the world") {
        static const dem_real corners[] = {0, 0, 0, DEM_R(0.2), 0, 0, DEM_R(0.1), DEM_R(0.2), 0};
        static const int32_t triangle[] = {0, 1, 2};
        dem_world *asked[2];
        int k;
        for (k = 0; k < 2; k++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_effect effects[DEM_EFFECTS];
            dem_material m;
            dem_mesh mesh;
            dem_motion up = DEM_MOTION;
            dem_wall walls[2];
            desc.gravity = at(0, 0, -9.81);
            asked[k] = dem_world_create(&desc);
            m = scene_material(asked[k], 1e6, 0.5, 0.3, 0);
            mesh.vertex_count = 3;
            mesh.triangle_count = 1;
            mesh.vertices = (dem_real *)corners;
            mesh.triangles = (int32_t *)triangle;
            walls[0] = dem_wall_mesh_add(asked[k], m, &mesh);
            walls[1] = dem_wall_mesh_add(asked[k], m, &mesh);       /* one upon the other: they share */
            up.kind = DEM_MOTION_TRANSLATING;
            up.velocity = at(0, 0, 0.01);
            CHECK_EQ(dem_wall_motion_set(asked[k], walls[0], &up), DEM_OK);
            CHECK_EQ(dem_wall_motion_set(asked[k], walls[1], &up), DEM_OK);
            dem_spheres_fill(asked[k], m, DEM_R(0.005),
                             dem_region_make(box_of(0.05, 0.02, 0.005, 0.15, 0.1, 0.05)), 40, 1);
            CHECK_EQ(dem_world_run_to(asked[k], 0.1, 0, 0), DEM_OK);
            if (k) CHECK(dem_effects_get(asked[k], 0.2, effects) > 0);
            CHECK_EQ(dem_world_run_to(asked[k], 0.15, 0, 0), DEM_OK);
        }
        CHECK(dem_world_hash_get(asked[0]) == dem_world_hash_get(asked[1]));
        for (k = 0; k < 2; k++) dem_world_destroy(asked[k]);
    }

    TEST("invalid motion tables are rejected with the row named") {
        dem_wall wall;
        dem_world *world = stage(&wall, 1e-3);
        dem_motion m = DEM_MOTION;
        dem_motion_row rows[3];
        m.kind = DEM_MOTION_TABLE;
        CHECK_EQ(dem_wall_motion_set(world, wall, &m), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "has 0 rows, must have at least 2");
        rows[0] = row(0, at(0, 0, 0), 0);
        rows[1] = row(1, at(0, 0, 0), 0);
        rows[2] = row(1, at(0, 0, 0), 0);
        m.table = rows;
        m.table_count = 3;
        CHECK_EQ(dem_wall_motion_set(world, wall, &m), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "row 2 of the table of wall 1, at 1 s");
        rows[0].time = 0.5;
        CHECK_EQ(dem_wall_motion_set(world, wall, &m), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "row 0");
        rows[0].time = 0;
        rows[1].position.x = DEM_R(1e300*1e300);
        CHECK_EQ(dem_wall_motion_set(world, wall, &m), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "row 1");
        dem_world_destroy(world);
    }
    TEST("a wall whose motion is set at every step carries grains as one that was set once, and lists last as long") {
        int periodic, mesh, set, k;
        for (periodic = 0; periodic < 2; periodic++)
            for (mesh = 0; mesh < 2; mesh++) {
                dem_body ball[2][9];
                dem_world *world[2];
                double off = 0;
                for (set = 0; set < 2; set++) {
                    dem_world_desc desc = DEM_WORLD_DESC;
                    dem_motion motion = DEM_MOTION;
                    dem_material m;
                    dem_wall belt;
                    desc.dt = DEM_R(2e-5);
                    desc.threads = 1;
                    desc.gravity.z = DEM_R(-9.81);
                    desc.domain = dem_box_make(0, 0, -1, DEM_R(0.2), DEM_R(0.2), 1);
                    if (periodic) desc.boundary[0] = desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
                    world[set] = dem_world_create(&desc);
                    m = scene_material(world[set], 1e6, 0.5, 0.5, 0);
                    belt = mesh ? scene_floor(world[set], m, 0, 0, 0.2, 0.2, 4, 4)
                        : dem_wall_plane_add(world[set], m, at(0, 0, 0), at(0, 0, 1));
                    for (k = 0; k < 9; k++)
                        ball[set][k] = dem_sphere_add(world[set], m, DEM_R(0.01),
                                                      at(0.05 + 0.05*(k%3), 0.05 + 0.05*(k/3), 0.0101 + 0.0002*k));
                    motion.kind = DEM_MOTION_TRANSLATING;
                    motion.velocity = at(0.3, 0.1, 0);
                    CHECK_EQ(dem_wall_motion_set(world[set], belt, &motion), DEM_OK);
                    for (k = 0; k < 8000; k++) {
                        if (set) CHECK_EQ(dem_wall_motion_set(world[set], belt, &motion), DEM_OK);
                        CHECK_EQ(scene_step(world[set], 1), DEM_OK);
                    }
                }
                for (k = 0; k < 9; k++) {
                    const dem_body_state a = scene_state(world[0], ball[0][k]), b = scene_state(world[1], ball[1][k]);
                    off = fmax(off, (double)demi_length(demi_sub(a.velocity, b.velocity)));
                    /* rolls without slip */
                    CHECK_NEAR(a.velocity.x, 0.3*2/7, 1e-4);
                }
                CHECK_NEAR(off, 0, fine ? 1e-8 : 1e-3);
                CHECK_NEAR(dem_counters_get(world[1]).rebuilds, (double)dem_counters_get(world[0]).rebuilds, 5);
                for (set = 0; set < 2; set++) dem_world_destroy(world[set]);
            }
    }

    TEST("a wall never jumps into an oscillation with a phase: it needs a ramp or a world before its first step") {
        int k, stepped, later, ramped;
        for (k = 0; k < 8; k++)
            for (stepped = 0; stepped < 2; stepped++)
                for (later = 0; later < 2; later++)
                    for (ramped = 0; ramped < 2; ramped++) {
                        const int jumps = k%4 != 0 && !ramped && (stepped || later);
                        dem_world_desc desc = DEM_WORLD_DESC;
                        dem_motion motion = DEM_MOTION;
                        dem_pose before, after;
                        dem_world *w = dem_world_create(&desc);
                        const dem_material m = scene_material(w, 1e7, 0.5, 0.3, 0);
                        const dem_wall wall = dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1));
                        dem_sphere_add(w, m, DEM_R(0.01), at(0, 0, 0.05));
                        if (stepped) CHECK_EQ(scene_step(w, 3), DEM_OK);
                        CHECK_EQ(dem_wall_pose_get(w, wall, &before), DEM_OK);
                        motion.kind = DEM_MOTION_OSCILLATING;
                        motion.velocity = at(0, 0, 2);
                        motion.amplitude = DEM_R(1e-3);
                        motion.frequency = 5;
                        motion.phase = (dem_real)(k*3.14159265358979/4);
                        motion.start = dem_world_time_get(w) + (later ? 0.01 : 0);
                        motion.ramp = ramped ? 0.01 : 0;
                        CHECK_EQ(dem_wall_motion_set(w, wall, &motion), jumps ? DEM_ERROR_ARGUMENT : DEM_OK);
                        if (jumps) CHECK_STR(dem_world_error_get(w), "would jump by");
                        CHECK_EQ(dem_wall_pose_get(w, wall, &after), DEM_OK);
                        CHECK_NEAR((double)after.position.z, jumps || ramped || later ? (double)before.position.z
                            : 1e-3*sin((double)motion.phase), 1e-9);
                        if (!jumps) {                      /* at rest until its start */
                            CHECK_EQ(scene_step(w, 2), DEM_OK);
                            CHECK_EQ(dem_wall_pose_get(w, wall, &after), DEM_OK);
                            if (later) CHECK_NEAR((double)after.velocity.z, 0, 0);
                            else if (!ramped) CHECK_NEAR((double)after.position.z, 1e-3*sin((double)motion.phase +
                                10*3.14159265358979*(dem_world_time_get(w) - motion.start)), 1e-8);
                        }
                        dem_world_destroy(w);
                    }
    }

    TEST("lists last as long for a small rotating wall far from the origin as for one at the origin") {
        int kind, far;
        for (kind = 0; kind < 3; kind++) {             /* mesh, profile, wall of grains */
            double rebuilds[2] = {0, 0}, speed[2] = {0, 0};
            for (far = 0; far < 2; far++) {
                const double x = far ? 0.5 : 0, h = 3e-3;
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_motion turn = DEM_MOTION;
                dem_world *w;
                dem_material m;
                dem_wall wall;
                dem_real v[12];
                int i;
                desc.dt = DEM_R(5e-6);
                w = dem_world_create(&desc);
                m = scene_material(w, 1e6, 0.5, 0.3, 0);
                for (i = 0; i < 4; i++) {
                    v[3*i] = (dem_real)(x + (i == 0 || i == 3 ? -h : h));
                    v[3*i + 1] = (dem_real)(x + (i < 2 ? -h : h));
                    v[3*i + 2] = 0;
                }
                if (kind == 0) {
                    static const int32_t corners[6] = {0, 1, 2, 0, 2, 3};
                    dem_mesh mesh;
                    memset(&mesh, 0, sizeof mesh);
                    mesh.vertex_count = 4; mesh.triangle_count = 2; mesh.vertices = v; mesh.triangles = (int32_t *)corners;
                    wall = dem_wall_mesh_add(w, m, &mesh);
                } else if (kind == 1) {
                    static const int32_t segments[8] = {0, 1, 1, 2, 2, 3, 3, 0};
                    dem_profile profile;
                    dem_real p[8];
                    for (i = 0; i < 8; i++) p[i] = v[3*(i/2) + i%2];
                    memset(&profile, 0, sizeof profile);
                    profile.vertex_count = profile.segment_count = 4;
                    profile.vertices = p; profile.segments = (int32_t *)segments;
                    wall = dem_wall_profile_add(w, m, &profile, DEM_EDGE_RESOLVED);
                } else wall = dem_wall_grains_add(w, m, 4, v, DEM_R(5e-4), 1);
                CHECK(wall.id);
                turn.kind = DEM_MOTION_ROTATING;
                turn.point = at(x, x, 0);
                turn.axis = at(0, 0, 1);
                turn.speed = 100;
                CHECK_EQ(dem_wall_motion_set(w, wall, &turn), DEM_OK);
                for (i = 0; i < 40; i++) dem_sphere_add(w, m, DEM_R(1e-3), at(x + 0.02 + 2.5e-3*(i%5), x + 2.5e-3*(i/5), 0));
                CHECK_EQ(scene_step(w, 1000), DEM_OK);
                rebuilds[far] = (double)dem_counters_get(w).rebuilds;
                speed[far] = demi_wall_speed(&w->walls[demi_wall_place(wall)]);
                dem_world_destroy(w);
            }
            CHECK_NEAR(rebuilds[1], rebuilds[0], 0.5*rebuilds[0] + 2);     /* the box turns with the wall */
            CHECK(speed[0] > 100*4.2e-3 && speed[0] < 100*5.3e-3);        /* half the diagonal; grains of 0.5 mm */
            CHECK(speed[1] > 100*4.2e-3 && speed[1] < 100*5.3e-3);
        }
    }

    TEST("a wall whose new motion begins at another pose presses on the grains that it finds there") {
        int kind, mesh, impulses, fresh;
        for (kind = 1; kind < 3; kind++)
            for (mesh = 0; mesh < 2; mesh++)
                for (impulses = 0; impulses < 2; impulses++) {
                    double z[2];
                    for (fresh = 0; fresh < 2; fresh++) {      /* 1: with a new list */
                        dem_world_desc desc = DEM_WORLD_DESC;
                        dem_motion_row rows[2];
                        dem_motion motion = DEM_MOTION;
                        dem_world *w;
                        dem_material m;
                        dem_wall wall;
                        dem_body b;
                        desc.dt = impulses ? DEM_R(1e-4) : DEM_R(1e-5);
                        if (impulses) desc.response = DEM_RESPONSE_IMPULSES;
                        w = dem_world_create(&desc);
                        m = scene_material(w, 1e7, 0.5, 0.3, 0);
                        wall = mesh ? scene_floor(w, m, -1, -1, 1, 1, 1, 1)
                            : dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1));
                        b = dem_sphere_add(w, m, DEM_R(0.01), at(0.1, 0, 0.042));   /* then 1 mm deep */
                        CHECK_EQ(scene_step(w, 20), DEM_OK);
                        motion.start = dem_world_time_get(w);
                        motion.kind = kind == 1 ? DEM_MOTION_TABLE : DEM_MOTION_USER;
                        memset(rows, 0, sizeof rows);
                        rows[0].position = rows[1].position = at(0, 0, 0.033);
                        rows[1].time = 10;
                        if (kind == 1) { motion.table = rows; motion.table_count = 2; }
                        if (kind == 2) motion.function = jumps;
                        CHECK_EQ(dem_wall_motion_set(w, wall, &motion), DEM_OK);
                        if (fresh) CHECK_EQ(dem_candidates_rebuild(w), DEM_OK);
                        CHECK_EQ(scene_step(w, 5), DEM_OK);
                        z[fresh] = (double)scene_state(w, b).position.z;
                        dem_world_destroy(w);
                    }
                    CHECK(z[0] > 0.042 + 1e-6);
                    CHECK_NEAR(z[0], z[1], fine ? 1e-15 : 1e-8);
                }
    }

    TEST("a repeating table is at rest before its start and carries no grain") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_motion motion = DEM_MOTION;
        dem_motion_row rows[5];
        dem_world *w;
        dem_material m;
        dem_wall wall;
        dem_wall_loads loads;
        dem_body b;
        dem_pose pose;
        int k;
        desc.gravity = at(0, 0, -9.81);
        w = dem_world_create(&desc);
        m = scene_material(w, 1e7, 0.5, 0.5, 0);
        wall = dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1));
        b = dem_sphere_add(w, m, DEM_R(0.005), at(0, 0, 0.00499));
        memset(rows, 0, sizeof rows);
        for (k = 0; k < 5; k++) {
            rows[k].time = 0.25*k;
            rows[k].position = at(k == 1 ? 0.05 : k == 3 ? -0.05 : 0, 0, 0);
        }
        motion.kind = DEM_MOTION_TABLE;
        motion.table = rows;
        motion.table_count = 5;
        motion.table_repeats = 1;
        motion.start = 0.1;
        CHECK_EQ(dem_wall_motion_set(w, wall, &motion), DEM_OK);
        CHECK_EQ(dem_world_run(w, 0.05, 0, 0), DEM_OK);
        CHECK_EQ(dem_wall_pose_get(w, wall, &pose), DEM_OK);
        CHECK_NEAR(pose.velocity.x, 0, 0);
        dem_wall_loads_get(w, wall, &loads);
        CHECK_NEAR(loads.work, 0, 0);
        CHECK_NEAR(scene_state(w, b).velocity.x, 0, 0);
        CHECK_EQ(dem_world_run(w, 0.06, 0, 0), DEM_OK);        /* it goes on at the speed of its first row */
        CHECK_EQ(dem_wall_pose_get(w, wall, &pose), DEM_OK);
        CHECK_REL(pose.velocity.x, 0.2, 0.1);
        dem_world_destroy(w);
    }
    return test_end();
}
