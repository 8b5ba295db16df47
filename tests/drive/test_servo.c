/* Servo walls: they reach the load that they are led to, account for their work, stop at their limit, and have the same bits
   in a slab. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const int fine = sizeof(dem_real) == 8;       /* double precision */

/* A world with a floor at z = 0 and without gravity; two grains of 1 cm, one on the floor. */
static const double R = 0.01;
static dem_world *stage(dem_world_desc *desc, const dem_material_desc *stuff, dem_material *material) {
    dem_world *world;
    desc->ledger = 1;
    world = dem_world_create(desc);
    if (!world) { puts(dem_world_create_error_get(desc)); exit(1); }
    *material = dem_material_add(world, stuff);
    dem_wall_plane_add(world, *material, at(0, 0, 0), at(0, 0, 1));
    return world;
}
static dem_motion press(double speed, double load) {
    dem_motion m = DEM_MOTION;
    m.kind = DEM_MOTION_SERVO;
    m.velocity.z = (dem_real)-speed;
    m.load = (dem_real)load;
    return m;
}
static dem_wall lid(dem_world *world, dem_material material, double z, const dem_motion *motion) {
    const dem_wall wall = dem_wall_plane_add(world, material, at(0, 0, z), at(0, 0, -1));
    CHECK_EQ(dem_wall_motion_set(world, wall, motion), DEM_OK);
    return wall;
}
static dem_servo servo_of(const dem_world *world, dem_wall wall) {
    dem_servo s;
    memset(&s, 0, sizeof s);
    CHECK_EQ(dem_wall_servo_get(world, wall, &s), DEM_OK);
    return s;
}
/* A square of two triangles at height z, from x = x0 to x1. */
static dem_wall plate(dem_world *world, dem_material material, double x0, double x1, double z) {
    dem_real p[12] = {(dem_real)x0, -1, (dem_real)z, (dem_real)x1, -1, (dem_real)z, (dem_real)x1, 1, (dem_real)z,
                      (dem_real)x0, 1, (dem_real)z};
    int32_t t[6] = {0, 2, 1, 0, 3, 2};
    dem_mesh mesh;
    mesh.vertex_count = 4; mesh.triangle_count = 2;
    mesh.vertices = p; mesh.triangles = t;
    return dem_wall_mesh_add(world, material, &mesh);
}
/* A spring and a dashpot, by pointer. */
static void own_law(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    (void)memory;
    f->normal = DEM_R(1e4)*c->overlap + 2*c->closing_speed;
}
/* The kinds of lids, and of grains below them. */
enum { PLANE, MESH, BEADS, DISC, LIDS };
enum { BALL, ELLIPSOID, CLUSTER, CUBE, SHAPES };
static dem_wall any_lid(dem_world *world, dem_material material, int kind, double z) {
    const dem_real bead[3] = {0, 0, (dem_real)(z + 0.5)}, radii[2] = {0, 1}, heights[2] = {0, 0};
    switch (kind) {
    case MESH: return plate(world, material, -1, 1, z);
    case BEADS: return dem_wall_grains_add(world, material, 1, bead, DEM_R(0.5), 1);
    case DISC: return dem_wall_revolved_add(world, material, at(0, 0, z), at(0, 0, 1), 2, radii, heights);
    default: return dem_wall_plane_add(world, material, at(0, 0, z), at(0, 0, -1));
    }
}
static void any_grain(dem_world *world, dem_material material, int kind) {
    const dem_real pair[6] = {DEM_R(-0.004), 0, 0, DEM_R(0.004), 0, 0};
    const dem_quat flat = dem_quat_make(1, 0, 0, 0);
    dem_cluster_desc two = DEM_CLUSTER_DESC;
    two.count = 2;
    two.positions = pair;
    two.radius = (dem_real)R;
    if (kind == BALL) dem_sphere_add(world, material, (dem_real)R, at(0, 0, R));
    else dem_body_add(world, material, kind == CUBE ? scene_box(world, 2*R, 2*R, 2*R) : kind == CLUSTER
                      ? dem_shape_cluster_add(world, &two) : dem_shape_ellipsoid_add(world, at(2*R, 2*R, R)), at(0, 0, R), flat);
}

/* A bed of 150 beads of 1.6 to 2.4 mm in a box with smooth sides of W, or periodic, at rest. *top: its height, m. It
   settles once, then it starts from the positions. */
enum { GRAINS = 150 };
static const double W = 0.012;
static dem_world *bed(int periodic, dem_material *material, double *top) {
    static dem_real x[2][3*GRAINS], r[2][GRAINS];
    static int settled[2];
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = scene_stuff(2e6, 0.4, 0.3, 0);
    dem_world *world;
    int i, k;
    desc.gravity.z = DEM_R(-9.81);
    desc.threads = 1;
    desc.impact_speed = DEM_R(0.3);
    if (periodic) {
        desc.domain = box_of(0, 0, -1, W, W, 1);
        desc.boundary[0] = desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
    }
    world = stage(&desc, &stuff, material);
    for (i = 0; i < 4 && !periodic; i++)
        CHECK(dem_wall_plane_add(world, *material, i == 1 ? at(W, 0, 0) : i == 3 ? at(0, W, 0) : at(0, 0, 0),
                                 i == 0 ? at(1, 0, 0) : i == 1 ? at(-1, 0, 0) : i == 2 ? at(0, 1, 0) : at(0, -1, 0)).id);
    if (settled[periodic]) CHECK_EQ(dem_spheres_add(world, *material, GRAINS, x[periodic], 0, r[periodic], 0), DEM_OK);
    else {
        dem_sizes sizes = DEM_SIZES;
        dem_bodies b;
        sizes.min = DEM_R(0.8e-3); sizes.max = DEM_R(1.2e-3); sizes.by_count = 1;
        CHECK_EQ(dem_sizes_fill(world, *material, &sizes, dem_region_make(box_of(0, 0, 0, W, W, 0.02)), GRAINS, 1), GRAINS);
        CHECK_EQ(dem_world_settle(world, 1, 0, 0, 0), DEM_OK);
        b = dem_bodies_get(world);
        for (i = 0; i < GRAINS; i++) {
            for (k = 0; k < 3; k++) x[periodic][3*i + k] = b.positions[4*i + k];
            r[periodic][i] = b.positions[4*i + 3];
        }
        settled[periodic] = 1;
    }
    for (i = 0, *top = 0; i < GRAINS; i++) *top = fmax(*top, (double)(x[periodic][3*i + 2] + r[periodic][i]));
    return world;
}
/* A table of stresses: the lid comes down, loading to 5 kPa, a pause, unloading. Its last time is 0.2 s. */
static const double PEAK = 5e3;
static void bed_loads(dem_motion *m, dem_motion_row *rows) {
    static const double time[] = {0, 0.05, 0.1, 0.15, 0.2}, part[] = {0.02, 0.02, 1, 1, 0.04};
    int k;
    memset(rows, 0, 5*sizeof *rows);
    for (k = 0; k < 5; k++) {
        rows[k].time = time[k];
        rows[k].load = (dem_real)(part[k]*PEAK);
    }
    *m = press(0.2, 0);
    m->area = (dem_real)(W*W);
    m->table = rows;
    m->table_count = 5;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("a sphere under a servo plane bears the target load, with the overlap of Hertz and of a linear spring") {
        int linear;
        for (linear = 0; linear < 2; linear++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_material_desc stuff = scene_stuff(1e7, 0.5, 0.3, 0);
            dem_material m;
            dem_world *world;
            dem_wall wall;
            dem_servo s;
            dem_pair pair;
            dem_pose pose;
            const double F = 10;
            const dem_motion motion = press(0.1, F);
            double overlap;
            desc.normal_law = linear ? DEM_NORMAL_LINEAR : DEM_NORMAL_HERTZ;
            if (linear) stuff.stiffness = 20000;
            world = stage(&desc, &stuff, &m);
            dem_sphere_add(world, m, (dem_real)R, at(0, 0, R));
            wall = lid(world, m, 2*R + 5e-4, &motion);
            CHECK_EQ(dem_world_run(world, 0.3, 0, 0), DEM_OK);
            s = servo_of(world, wall);
            CHECK_REL(s.force, F, fine ? 1e-11 : 1e-5);
            CHECK_REL(s.target, F, 1e-7);
            CHECK_NEAR(s.speed, 0, fine ? 1e-11 : 1e-5);
            dem_pair_get(world, m, m, &pair);
            overlap = linear ? F/(double)pair.stiffness : pow(3*F/(4*(double)pair.young_eff*sqrt(R)), 2.0/3);
            dem_wall_pose_get(world, wall, &pose);
            CHECK_REL(2*R - (double)pose.position.z, 2*overlap, fine ? 1e-10 : 1e-4);  /* floor and lid */
            CHECK_REL(s.travel, 5e-4 + 2*overlap, fine ? 1e-10 : 1e-4);
            CHECK_REL(s.stiffness, linear ? F/overlap : 1.5*F/overlap, fine ? 1e-9 : 1e-4);
            dem_world_destroy(world);
        }
    }
    TEST("a servo wall reaches its load with every law and restitution, kind of wall and shape of grain") {
        static const double restitution[] = {0.1, 1};
        int law, e, kind, shape, n = 0;
        for (law = 0; law < 4; law++) for (e = 0; e < 2; e++) for (kind = 0; kind < LIDS; kind++) for (shape = 0; shape < SHAPES; shape++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_material_desc stuff = scene_stuff(1e7, restitution[e], 0.3, 0);
            dem_motion motion = press(0.02, 2);
            dem_material m;
            dem_world *world;
            dem_wall wall;
            dem_servo s;
            if (kind == DISC && shape == ELLIPSOID) continue;      /* have no contact */
            desc.normal_law = law == 1 ? DEM_NORMAL_LINEAR : law == 2 ? DEM_NORMAL_HYSTERETIC : DEM_NORMAL_HERTZ;
            if (law == 3) { desc.law = own_law; desc.law_stiffness = 10000; stuff.restitution = DEM_R(0.8); }
            if ((law == 3 && e) || (law == 2 && !e && !fine)) continue;    /* unloads too steeply for single precision */
            world = stage(&desc, &stuff, &m);
            any_grain(world, m, shape);
            wall = any_lid(world, m, kind, 2*R + 1e-5);
            CHECK_EQ(dem_wall_motion_set(world, wall, &motion), DEM_OK);
            CHECK_EQ(dem_world_run(world, 0.05, 0, 0), DEM_OK);
            s = servo_of(world, wall);
            CHECK_REL(s.force, 2, fine ? 0.01 : 0.05);
            n++;
            dem_world_destroy(world);
        }
        CHECK_EQ(n, (fine ? 7 : 6)*15);
    }
    TEST("a servo wall that pulls at a grain across a gap, which its law holds, reaches its load") {
        dem_world_desc desc = DEM_WORLD_DESC;
        const dem_material_desc stuff = scene_stuff(1e7, 0.8, 0.3, 0);
        dem_motion motion = press(0.02, -0.1);
        dem_material m;
        dem_world *world;
        dem_wall wall;
        desc.law = own_law;
        desc.law_stiffness = 10000;
        desc.law_range = DEM_R(1e-3);
        world = stage(&desc, &stuff, &m);
        any_grain(world, m, BALL);
        wall = lid(world, m, 2*R + 1e-5, &motion);
        CHECK_EQ(dem_world_run(world, 0.2, 0, 0), DEM_OK);
        CHECK_REL(servo_of(world, wall).force, -0.1, fine ? 0.01 : 0.05);
        CHECK(servo_of(world, wall).stiffness > 0);
        dem_world_destroy(world);
    }
    TEST("an oedometer follows a table of stresses within 1 % in loading and unloading, of planes and periodic") {
        int periodic;
        for (periodic = 0; periodic < 2; periodic++) {
            double top, worst = 0, sum = 0;
            dem_motion motion;
            dem_motion_row rows[5];
            dem_material m;
            dem_world *world = bed(periodic, &m, &top);
            dem_wall wall;
            int n = 0;
            bed_loads(&motion, rows);
            wall = lid(world, m, top, &motion);
            while (n < 400) {
                dem_servo s;
                CHECK_EQ(dem_world_run(world, 0.2/400, 0, 0), DEM_OK);
                s = servo_of(world, wall);
                n++;
                if (n < 100 || s.target < 0.05*PEAK*W*W) continue;      /* the lid comes down on the bed */
                worst = fmax(worst, fabs(s.force/s.target - 1));
                sum += fabs(s.force/s.target - 1)/300;
            }
            if (getenv("SERVO_NUMBERS")) printf("periodic %d: largest error %.2g, mean %.2g\n", periodic, worst, sum);
            CHECK(worst < 0.01);
            scene_report_has(world, "target 0.0288");
            dem_world_destroy(world);
        }
    }
    TEST("the work of a servo wall is in the ledger, whose residual is that of a wall of constant speed") {
        int kind;
        double residual[2];
        for (kind = 0; kind < 2; kind++) {
            double top;
            dem_motion motion = press(0.05, 0.7);
            dem_material m;
            dem_world *world = bed(0, &m, &top);
            dem_ledger before = dem_ledger_get(world), after;
            dem_wall_loads loads;
            dem_wall wall;
            motion.kind = kind ? DEM_MOTION_SERVO : DEM_MOTION_TRANSLATING;
            if (!kind) motion.velocity.z = DEM_R(-0.01);
            wall = lid(world, m, top, &motion);
            CHECK_EQ(dem_world_run(world, 0.1, 0, 0), DEM_OK);
            after = dem_ledger_get(world);
            dem_wall_loads_get(world, wall, &loads);
            residual[kind] = fabs(after.residual - before.residual)/(after.walls - before.walls);
            CHECK(after.walls - before.walls > 1e-7);
            CHECK_REL(loads.work, after.walls - before.walls, fine ? 1e-9 : 1e-4);
            dem_world_destroy(world);
        }
        if (getenv("SERVO_NUMBERS")) printf("residual over work: constant speed %.2g, servo %.2g\n", residual[0], residual[1]);
        CHECK(residual[1] < (fine ? 2*residual[0] + 1e-4 : 0.05));
    }
    TEST("without grains a servo wall moves at its largest speed, and stops at the limit of its travel") {
        dem_world_desc desc = DEM_WORLD_DESC;
        const dem_material_desc stuff = scene_stuff(1e7, 0.5, 0.3, 0);
        dem_motion motion = press(0.5, 10);
        dem_material m;
        dem_world *world;
        dem_wall wall, back;
        dem_pose pose;
        desc.dt = DEM_R(1e-4);
        world = stage(&desc, &stuff, &m);
        motion.start = 0.01;
        motion.travel = DEM_R(0.1);
        wall = lid(world, m, 1, &motion);
        motion.load = -10;                              /* pulls */
        back = lid(world, m, 1, &motion);
        CHECK_EQ(dem_world_run(world, 0.11, 0, 0), DEM_OK);
        dem_wall_pose_get(world, wall, &pose);
        CHECK_NEAR((double)pose.position.z, 0.95, fine ? 1e-12 : 1e-4);     /* single: a step more */
        CHECK_NEAR((double)pose.velocity.z, -0.5, 1e-7);
        CHECK_EQ(dem_world_run(world, 0.2, 0, 0), DEM_OK);
        dem_wall_pose_get(world, wall, &pose);
        CHECK_NEAR((double)pose.position.z, 0.9, fine ? 1e-12 : 1e-6);
        CHECK_NEAR((double)pose.velocity.z, 0, fine ? 1e-10 : 1e-6);
        dem_wall_pose_get(world, back, &pose);
        CHECK_NEAR((double)pose.position.z, 1.1, fine ? 1e-12 : 1e-6);
        scene_report_has(world, "the limit of its travel");
        dem_world_destroy(world);
    }
    TEST("a target rises over its ramp, and a table of loads is linear, repeats, and stays at its last load") {
        dem_motion m = press(1, 8);
        dem_motion_row rows[3];
        memset(rows, 0, sizeof rows);
        m.start = 1; m.ramp = 2; m.area = DEM_R(0.5);
        CHECK_NEAR(demi_servo_target(&m, 2), 2, 1e-6);          /* half of 8 Pa on 0.5 m2 */
        CHECK_NEAR(demi_servo_target(&m, 5), 4, 1e-6);
        m.ramp = 0;
        rows[1].time = 1; rows[2].time = 3;
        rows[0].load = 2; rows[1].load = 6; rows[2].load = 4;
        m.table = rows; m.table_count = 3;
        CHECK_NEAR(demi_servo_target(&m, 1.25), 1.5, 1e-6);
        CHECK_NEAR(demi_servo_target(&m, 3), 2.5, 1e-6);
        CHECK_NEAR(demi_servo_target(&m, 9), 2, 1e-6);
        m.table_repeats = 1;
        CHECK_NEAR(demi_servo_target(&m, 1 + 3 + 0.25), 1.5, 1e-6);
    }
    TEST("servo walls with equal motions are one piston, which bears the load together") {
        dem_world_desc desc = DEM_WORLD_DESC;
        const dem_material_desc stuff = scene_stuff(1e7, 0.5, 0.3, 0);
        const dem_motion motion = press(0.1, 10);
        dem_material m;
        dem_world *world = stage(&desc, &stuff, &m);
        dem_wall half[2], apart;
        dem_wall_loads loads[2];
        dem_motion other = press(0.1, 3);
        dem_pose pose[2];
        int i;
        for (i = 0; i < 3; i++) dem_sphere_add(world, m, (dem_real)R, at(i == 2 ? 3 : i ? 0.3 : -0.2, 0, R));
        for (i = 0; i < 2; i++) half[i] = plate(world, m, i ? 0 : -1, i ? 1 : 0, 2*R + 1e-4);
        apart = plate(world, m, 2, 4, 2*R + 1e-4);
        for (i = 0; i < 2; i++) CHECK_EQ(dem_wall_motion_set(world, half[i], &motion), DEM_OK);
        CHECK_EQ(dem_wall_motion_set(world, apart, &other), DEM_OK);
        CHECK_EQ(dem_world_run(world, 0.2, 0, 0), DEM_OK);
        for (i = 0; i < 2; i++) {
            dem_wall_loads_get(world, half[i], &loads[i]);
            dem_wall_pose_get(world, half[i], &pose[i]);
            CHECK_REL(servo_of(world, half[i]).force, 10, fine ? 1e-9 : 1e-4);
            CHECK_REL((double)loads[i].force.z, 5, fine ? 1e-9 : 1e-3);
        }
        CHECK(!memcmp(&pose[0].velocity, &pose[1].velocity, sizeof pose[0].velocity));
        CHECK_REL(servo_of(world, apart).force, 3, fine ? 1e-9 : 1e-4);
        dem_world_destroy(world);
    }
    TEST("a servo wall in a planar world presses discs; a load that changes in mid-run is reached again") {
        dem_world_desc desc = DEM_WORLD_DESC;
        const dem_material_desc stuff = scene_stuff(1e7, 0.5, 0.3, 0);
        dem_motion motion = press(0.1, 10);
        dem_material m;
        dem_world *world;
        dem_wall wall;
        desc.planar = 1;
        world = dem_world_create(&desc);
        m = dem_material_add(world, &stuff);
        dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 1, 0));
        dem_sphere_add(world, m, (dem_real)R, at(0, R, 0));
        wall = dem_wall_plane_add(world, m, at(0, 2*R + 1e-4, 0), at(0, -1, 0));
        CHECK(dem_wall_motion_set(world, wall, &motion) != DEM_OK);
        CHECK_STR(dem_world_error_get(world), "must be 0 in a planar world");
        motion.velocity = at(0, -0.1, 0);
        CHECK_EQ(dem_wall_motion_set(world, wall, &motion), DEM_OK);
        CHECK_EQ(dem_world_run(world, 0.4, 0, 0), DEM_OK);
        CHECK_REL(servo_of(world, wall).force, 10, 1e-4);
        motion.load = 4;
        CHECK_EQ(dem_wall_motion_set(world, wall, &motion), DEM_OK);
        CHECK_EQ(dem_world_run(world, 0.4, 0, 0), DEM_OK);
        CHECK_REL(servo_of(world, wall).force, 4, 1e-4);
        dem_world_destroy(world);
    }
    TEST("dem.h refuses wrong values of a servo wall, and names impulses as a reason") {
        dem_world_desc desc = DEM_WORLD_DESC;
        const dem_material_desc stuff = scene_stuff(1e7, 0.5, 0.3, 0);
        dem_material m;
        dem_world *world = stage(&desc, &stuff, &m);
        const dem_wall wall = dem_wall_plane_add(world, m, at(0, 0, 1), at(0, 0, -1));
        dem_motion_row rows[2];
        dem_motion motion = press(0, 1);
        dem_servo s;
        memset(rows, 0, sizeof rows);
        rows[1].time = 1;
        CHECK(dem_wall_servo_get(world, wall, &s) != DEM_OK);
        CHECK_STR(dem_world_error_get(world), "is not DEM_MOTION_SERVO");
        CHECK(dem_wall_motion_set(world, wall, &motion) != DEM_OK);
        CHECK_STR(dem_world_error_get(world), "velocity of servo wall 2 is zero");
        motion = press(1, HUGE_VAL);
        CHECK(dem_wall_motion_set(world, wall, &motion) != DEM_OK);
        CHECK_STR(dem_world_error_get(world), "load of wall 2 is inf");
        motion = press(1, 1);
        motion.area = -1;
        CHECK(dem_wall_motion_set(world, wall, &motion) != DEM_OK);
        CHECK_STR(dem_world_error_get(world), "area of wall 2 is -1 m2");
        motion.area = 0;
        motion.travel = -1;
        CHECK(dem_wall_motion_set(world, wall, &motion) != DEM_OK);
        CHECK_STR(dem_world_error_get(world), "travel of wall 2 is -1 m");
        motion.travel = 0;
        motion.table = rows;
        CHECK(dem_wall_motion_set(world, wall, &motion) != DEM_OK);
        CHECK_STR(dem_world_error_get(world), "must have at least 2");
        motion.table_count = 2;
        rows[1].load = (dem_real)NAN;
        CHECK(dem_wall_motion_set(world, wall, &motion) != DEM_OK);
        CHECK_STR(dem_world_error_get(world), "row 1 of the table of wall 2");
        dem_world_destroy(world);
        desc.response = DEM_RESPONSE_IMPULSES;
        desc.dt = DEM_R(1e-3);
        world = stage(&desc, &stuff, &m);
        motion = press(1, 1);
        CHECK(dem_wall_motion_set(world, dem_wall_plane_add(world, m, at(0, 0, 1), at(0, 0, -1)), &motion) != DEM_OK);
        CHECK_STR(dem_world_error_get(world), "contacts of this world are impulses");
        dem_world_destroy(world);
    }
    TEST("servo walls with equal motions are one piston, also if their materials ignore different ones") {
        dem_world_desc desc = DEM_WORLD_DESC;
        const dem_material_desc stuff = scene_stuff(1e7, 0.5, 0.3, 0);
        const dem_motion motion = press(0.05, 1);
        dem_material m, other, dust;
        dem_world *world = stage(&desc, &stuff, &m);
        dem_wall half[2];
        dem_pair pair;
        int i;
        other = dem_material_add(world, &stuff);
        dust = dem_material_add(world, &stuff);
        dem_pair_get(world, other, dust, &pair);
        pair.ignored = 1;
        CHECK_EQ(dem_pair_set(world, other, dust, &pair), DEM_OK);
        dem_sphere_add(world, m, (dem_real)R, at(-0.2, 0, R));         /* under the first half only */
        for (i = 0; i < 2; i++) {
            half[i] = plate(world, i ? other : m, i ? 0 : -1, i ? 1 : 0, 2*R + 1e-4);
            CHECK_EQ(dem_wall_motion_set(world, half[i], &motion), DEM_OK);
        }
        CHECK_EQ(dem_world_run(world, 0.05, 0, 0), DEM_OK);
        CHECK_NEAR(servo_of(world, half[0]).travel, servo_of(world, half[1]).travel, 0);
        CHECK_NEAR(servo_of(world, half[0]).speed, servo_of(world, half[1]).speed, 0);
        CHECK_REL(servo_of(world, half[1]).force, 1, 1e-2);
        dem_world_destroy(world);
    }
    return test_end();
}
