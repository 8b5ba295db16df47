/* dem_world_check: names what was planted in a scene that is right otherwise, and is silent on scenes of practice. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

/* A tray of 60 glass beads that fall onto a plane between four more; each number is what a mistake changes. */
typedef struct tray {
    double radius, density, young, friction, rolling, gravity, dt, drop, scale, mesh, wall_speed, impact_speed;
    int grains, floor, normal_up, hidden, outflow, spare_material, threads, inside, heavy;
} tray;
static const tray TRAY = {1e-3, 2500, 1e7, 0.3, 0.05, -9.81, 0, 0.002, 1, 0, 0, 0, 60, 1, 1, 0, 0, 0, 1, 0, 0};
static dem_world *tray_make(const tray *t) {
    const double r = t->radius;
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc glass = scene_stuff(t->young, 0.6, t->friction, t->rolling);
    dem_world *world;
    dem_material m;
    int i;
    glass.density = (dem_real)t->density;
    desc.gravity.z = (dem_real)t->gravity;
    desc.dt = (dem_real)t->dt;
    desc.threads = t->threads;
    desc.impact_speed = (dem_real)t->impact_speed;
    desc.allow_large_dt = t->wall_speed > 0;
    for (i = 0; i < 3; i++) if (t->outflow) desc.boundary[i] = DEM_BOUNDARY_OUTFLOW;
    desc.domain = box_of(-r, -r, -r, 20*r, 20*r, 8*r);
    world = dem_world_create(&desc);
    m = dem_material_add(world, &glass);
    if (t->spare_material) dem_material_add(world, &glass);
    if (t->floor) dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, t->normal_up ? 1 : -1));
    dem_wall_plane_add(world, m, at(-r, 0, 0), at(1, 0, 0));
    dem_wall_plane_add(world, m, at(0, -r, 0), at(0, 1, 0));
    if (t->mesh > 0) {
        dem_wall wall = scene_floor(world, m, 0, 0, t->mesh, t->mesh, 2, 2);
        dem_motion motion = DEM_MOTION;
        motion.kind = DEM_MOTION_TRANSLATING;
        motion.velocity = at(t->wall_speed, 0, 0);
        if (t->wall_speed > 0) dem_wall_motion_set(world, wall, &motion);
    }
    if (t->hidden) {
        dem_mesh mesh;
        dem_real p[9] = {0, 0, -1, DEM_R(0.01), 0, -1, 0, DEM_R(0.01), -1};
        int32_t c[3] = {0, 1, 2};
        mesh.vertex_count = 3; mesh.triangle_count = 1; mesh.vertices = p; mesh.triangles = c;
        dem_wall_mesh_add(world, m, &mesh);
    }
    for (i = 0; i < t->grains; i++)
        dem_sphere_add(world, m, (dem_real)r, at(2.1*r*(i%5), 2.1*r*(i/5%4), t->drop + r + 2.1*r*(i/20)));
    if (t->inside) dem_sphere_add(world, m, (dem_real)r, at(0.3*r, 0, t->drop + r));
    if (t->outflow > 1) dem_sphere_add(world, m, (dem_real)r, at(30*r, 0, 5*r));
    if (t->heavy) {                             /* a column of 200 in a footprint of one */
        for (i = 0; i < 2000; i++) dem_sphere_add(world, m, (dem_real)r, at(3*r, 3*r, t->drop + 20*r + 2.01*r*i));
    }
    return world;
}
/* How many findings; `says` must be in one of them, of that severity. */
static int tray_check(const tray *t, dem_severity severity, const char *says) {
    dem_world *world = tray_make(t);
    dem_finding f[32];
    const int n = dem_world_check(world, f, 32);
    int i, found = !says;
    for (i = 0; i < n && i < 32; i++) {
        if (says && strstr(f[i].text, says) && f[i].severity == severity) found = 1;
        if (i) CHECK(f[i].severity <= f[i - 1].severity);
        CHECK(strlen(f[i].text) < sizeof f[i].text - 1);
    }
    CHECK(found);
    if (!found) { printf("not found: %s\n", says); for (i = 0; i < n && i < 32; i++) puts(f[i].text); }
    if (n && !says) for (i = 0; i < n && i < 32; i++) puts(f[i].text);
    dem_world_destroy(world);
    return n;
}

/* A closed surface of half width H about `centre`, which does not move against itself: a mesh; the same in six
   walls; with two corners on the sides of others; turned inside out; a profile; a can; a ring of square section.
   open: a piece is left out. Answers how many of the 27 places about its centre are inside. */
enum { BODY_MESH, BODY_SIX, BODY_JUNCTION, BODY_INSIDE_OUT, BODY_PROFILE, BODY_CAN, BODY_RING, BODIES };
static const double H = 0.01;
static int body_make(dem_world *world, dem_material m, int kind, dem_vec3 centre, int open, const dem_motion *motion) {
    static const int32_t faces[36] = {0,2,1, 1,2,3, 4,5,6, 5,7,6, 0,1,4, 1,5,4, 2,6,3, 3,6,7, 0,4,2, 2,4,6, 1,3,5, 3,7,5};
    /* the top, 4 5 7 6, cut in three from 8, half way from 4 to 5 */
    static const int32_t top[9] = {4,8,6, 8,7,6, 8,5,7};
    dem_real p[27];
    int32_t t[39];
    int i, k, first = world->wall_count;
    if (kind <= BODY_INSIDE_OUT) {
        dem_mesh mesh;
        scene_box_points(2*H, 2*H, 2*H, p);
        p[24] = 0; p[25] = DEM_R(-0.01); p[26] = DEM_R(0.01);
        for (i = 0; i < 9; i++)
            for (k = 0; k < 3; k++) p[3*i + k] += k == 0 ? centre.x : k == 1 ? centre.y : centre.z;
        memcpy(t, faces, sizeof faces);
        mesh.vertex_count = 9; mesh.vertices = p; mesh.triangle_count = 12 - open; mesh.triangles = t;
        if (kind == BODY_JUNCTION) {
            memcpy(t, top, sizeof top);
            memcpy(t + 9, faces, 6*sizeof *t);
            memcpy(t + 15, faces + 12, 24*sizeof *t);
            mesh.triangle_count = 13 - open;
        }
        for (i = 0; i < 12 && kind == BODY_INSIDE_OUT; i++) { t[3*i] = faces[3*i + 1]; t[3*i + 1] = faces[3*i]; }
        for (i = 0; i < (kind == BODY_SIX ? 6 - open : 1); i++) {
            if (kind == BODY_SIX) { mesh.triangle_count = 2; mesh.triangles = t + 6*i; }
            CHECK(dem_wall_mesh_add(world, m, &mesh).id > 0);
        }
    } else if (kind == BODY_PROFILE) {
        dem_profile profile;
        for (i = 0; i < 4; i++) {
            p[2*i] = centre.x + (dem_real)(i == 0 || i == 3 ? -H : H);
            p[2*i + 1] = centre.y + (dem_real)(i < 2 ? -H : H);
            t[2*i] = i;
            t[2*i + 1] = (i + 1)%4;
        }
        profile.vertex_count = 4; profile.vertices = p; profile.segment_count = 4 - open; profile.segments = t;
        CHECK(dem_wall_profile_add(world, m, &profile, DEM_EDGE_RESOLVED).id > 0);
    } else {
        const dem_real can[8] = {0, DEM_R(0.01), DEM_R(0.01), 0, DEM_R(-0.01), DEM_R(-0.01), DEM_R(0.01), DEM_R(0.01)};
        const dem_real ring[10] = {DEM_R(0.003), DEM_R(0.012), DEM_R(0.012), DEM_R(0.003), DEM_R(0.003),
                                   DEM_R(-0.01), DEM_R(-0.01), DEM_R(0.01), DEM_R(0.01), DEM_R(-0.01)};
        const int n = kind == BODY_CAN ? 4 : 5;
        const dem_real *r = kind == BODY_CAN ? can : ring;
        CHECK(dem_wall_revolved_add(world, m, centre, at(0, 0, 1), n - open, r, r + n).id > 0);
    }
    for (i = first; i < world->wall_count && motion; i++) {
        dem_wall wall;
        wall.id = i + 1;
        CHECK_EQ(dem_wall_motion_set(world, wall, motion), DEM_OK);
    }
    return kind == BODY_RING ? 24 : 27;
}
/* Grains at 27 places half a width apart, in line with corners and edges, or five far away. */
static void body_grains(dem_world *world, dem_material m, dem_vec3 centre, int far_away) {
    int i;
    for (i = 0; i < (far_away ? 5 : 27); i++)
        dem_sphere_add(world, m, DEM_R(1e-4), far_away ? dem_vec3_make(centre.x, DEM_R(0.05) + centre.y, (dem_real)(i*1e-3))
            : dem_vec3_make(centre.x + (dem_real)((i%3 - 1)*H/2), centre.y + (dem_real)((i/3%3 - 1)*H/2),
                            centre.z + (dem_real)((i/9 - 1)*H/2)));
}
/* Findings that begin with `says`: their number; one of them must have this severity. */
static int body_findings(dem_world *world, const char *says, dem_severity severity) {
    dem_finding f[32];
    const int n = dem_world_check(world, f, 32);
    int i, count = 0;
    for (i = 0; i < n && i < 32; i++) {
        if (!strstr(f[i].text, says)) continue;
        count++;
        CHECK_EQ(f[i].severity, severity);
        CHECK(strlen(f[i].text) < sizeof f[i].text - 1);
    }
    return count;
}

static dem_real swells(const dem_body_state *body, dem_body id, double time, void *user) {
    (void)body; (void)id; (void)time; (void)user;
    return DEM_R(1e-3);                        /* m/s */
}
/* One ball at rest without gravity, and what moves it: nothing; a cell that deforms; a wall that moves; one whose
   surface does; growth; a feed. */
enum { MOVED_NOT, MOVED_CELL, MOVED_WALL, MOVED_BELT, MOVED_GROWTH, MOVED_FEED, MOVES };
static dem_world *rest(int moved) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_motion motion = DEM_MOTION;
    dem_cell_desc cell = DEM_CELL_DESC;
    dem_feed_desc feed = DEM_FEED_DESC;
    dem_world *world;
    dem_material m;
    dem_wall wall;
    int k;
    desc.threads = 1;
    desc.domain = box_of(0, 0, 0, 0.1, 0.1, 0.1);
    for (k = 0; k < 3 && moved == MOVED_CELL; k++) desc.boundary[k] = DEM_BOUNDARY_PERIODIC;
    if (moved == MOVED_GROWTH) desc.growth = swells;
    world = dem_world_create(&desc);
    m = scene_material(world, 1e7, 0.5, 0.3, 0);
    dem_sphere_add(world, m, DEM_R(0.006), at(0.05, 0.05, 0.05));
    if (moved == MOVED_CELL) {
        cell.rate = at(-1, -1, -1);
        CHECK_EQ(dem_cell_set(world, &cell), DEM_OK);
        return world;
    }
    wall = dem_wall_plane_add(world, m, at(0.01, 0, 0), at(1, 0, 0));
    motion.kind = DEM_MOTION_TRANSLATING;
    motion.velocity = at(1, 0, 0);
    if (moved == MOVED_WALL) CHECK_EQ(dem_wall_motion_set(world, wall, &motion), DEM_OK);
    if (moved == MOVED_BELT) CHECK_EQ(dem_wall_surface_velocity_set(world, wall, at(0, 1, 0)), DEM_OK);
    feed.material = m;
    feed.class_count = 1; feed.radius[0] = DEM_R(0.003); feed.amount[0] = 1; feed.rate = 10;
    feed.box = box_of(0.02, 0.02, 0.08, 0.08, 0.08, 0.09);
    feed.velocity = at(0, 0, -1);
    if (moved == MOVED_FEED) CHECK(dem_feed_add(world, &feed).id > 0);
    return world;
}
/* A ball under gravity without a floor, and what holds or takes it. */
enum { HELD_NOT, HELD_JOINT, HELD_RAIL, HELD_OUTFLOW, HOLDS };
static dem_world *hung(int held) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_joint_desc joint = DEM_JOINT_DESC;
    dem_rail_desc rail = DEM_RAIL_DESC;
    dem_world *world;
    dem_body ball;
    desc.threads = 1;
    desc.gravity = at(0, 0, -9.81);
    desc.domain = box_of(-1, -1, -1, 1, 1, 1);
    if (held == HELD_OUTFLOW) desc.boundary[2] = DEM_BOUNDARY_OUTFLOW;
    if (held == HELD_JOINT) {
        desc.response = DEM_RESPONSE_IMPULSES;
        desc.dt = DEM_R(1e-3);
        desc.orientations = 1;
    }
    world = dem_world_create(&desc);
    ball = dem_sphere_add(world, scene_material(world, 1e7, 0.5, 0.3, 0), DEM_R(0.01), at(0, 0, 0));
    joint.kind = DEM_JOINT_POINT;
    joint.a = ball;
    joint.point = at(-0.01, 0, 0);
    rail.axes = DEM_RAIL_ALL;
    if (held == HELD_JOINT) CHECK(dem_joint_add(world, &joint).id > 0);
    if (held == HELD_RAIL) CHECK_EQ(dem_body_rail_set(world, ball, &rail), DEM_OK);
    return world;
}
/* Two bars that cross at the same place like scissors. */
enum { BARS_LOOSE, BARS_HINGED, BARS_COLLIDE, BARS };
static dem_world *scissors(int way) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_joint_desc joint = DEM_JOINT_DESC;
    dem_world *world;
    dem_material m;
    dem_shape bar;
    desc.threads = 1;
    desc.gravity = at(0, 0, -9.81);
    desc.response = DEM_RESPONSE_IMPULSES;
    desc.dt = DEM_R(1e-3);
    world = dem_world_create(&desc);
    m = scene_material(world, 1e7, 0.5, 0.3, 0);
    dem_wall_plane_add(world, m, at(0, 0, -0.02), at(0, 0, 1));
    bar = scene_box(world, 0.06, 0.008, 0.01);
    joint.kind = DEM_JOINT_REVOLUTE;
    joint.a = dem_body_add(world, m, bar, at(0, 0, 0), dem_quat_about(at(0, 0, 1), DEM_R(0.6)));
    joint.b = dem_body_add(world, m, bar, at(0, 0, 0), dem_quat_about(at(0, 0, 1), DEM_R(-0.6)));
    joint.axis = at(0, 0, 1);
    joint.collide = way == BARS_COLLIDE;
    if (way != BARS_LOOSE) CHECK(dem_joint_add(world, &joint).id > 0);
    return world;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("a scene without mistakes has no finding, and checking changes no bit of its run") {
        dem_world *a = tray_make(&TRAY), *b = tray_make(&TRAY);
        dem_finding f;
        CHECK_EQ(tray_check(&TRAY, DEM_SEVERITY_NOTE, 0), 0);
        CHECK_EQ(scene_step(a, 500), DEM_OK);
        CHECK_EQ(dem_world_check(b, &f, 1), 0);
        CHECK_EQ(scene_step(b, 250), DEM_OK);
        CHECK_EQ(dem_world_check(b, 0, 0), 0);
        CHECK_EQ(scene_step(b, 250), DEM_OK);
        CHECK(dem_world_hash_get(a) == dem_world_hash_get(b));
        dem_world_destroy(a);
        dem_world_destroy(b);
        CHECK_EQ(dem_world_check(0, &f, 1), 0);
    }
    TEST("dem_world_check finds each of 24 planted mistakes and gives its value") {
#define PLANT(change, severity, says) do { tray t = TRAY; change; CHECK(tray_check(&t, severity, says) > 0); } while (0)
        PLANT(t.grains = 0, DEM_SEVERITY_ERROR, "no grain can move, and there is no feed");
        PLANT(t.gravity = 0, DEM_SEVERITY_WARNING, "neither gravity nor a force");
        PLANT(t.floor = 0, DEM_SEVERITY_WARNING, "grains fall for ever");
        PLANT(t.gravity = 9.81, DEM_SEVERITY_WARNING, "gravity is (0, 0, 9.81) m/s2");
        PLANT(t.radius = 2; t.drop = 4, DEM_SEVERITY_WARNING, "was 2 mm meant?");
        PLANT(t.radius = 5e-8; t.drop = 1e-7, DEM_SEVERITY_WARNING, "radius of 5e-08 m");
        PLANT(t.density = 2.5, DEM_SEVERITY_WARNING, "was 2.5 g/cm3 meant?");
        PLANT(t.young = 70; t.dt = 1e-5, DEM_SEVERITY_WARNING, "Young's modulus of 70 Pa");
        PLANT(t.friction = 30, DEM_SEVERITY_WARNING, "tan(30 degrees) is 0.577");
        PLANT(t.rolling = 20, DEM_SEVERITY_WARNING, "rolling friction of 20");
        PLANT(t.mesh = 300, DEM_SEVERITY_WARNING, "wall 4, a mesh, is 300 m long");
        PLANT(t.mesh = 1e-4, DEM_SEVERITY_WARNING, "is it in other units?");
        PLANT(t.hidden = 1, DEM_SEVERITY_WARNING, "nothing can reach it");
        PLANT(t.normal_up = 0, DEM_SEVERITY_ERROR, "grains overlap walls");
        PLANT(t.drop = -0.0005, DEM_SEVERITY_WARNING, "body 1 wall 1 by 0.5");
        PLANT(t.inside = 1, DEM_SEVERITY_ERROR, "bodies 1 and 61 by");
        PLANT(t.outflow = 2, DEM_SEVERITY_WARNING, "1 grain is outside the domain");
        PLANT(t.dt = 1e-3, DEM_SEVERITY_ERROR, "dt is 0.001 s, must be at most");
        PLANT(t.dt = 1e-9, DEM_SEVERITY_NOTE, "times smaller than necessary");
        PLANT(t.impact_speed = 20, DEM_SEVERITY_WARNING, "of their radius at 20 m/s");
        PLANT(t.heavy = 1; t.young = 1e5, DEM_SEVERITY_WARNING, "N each");
        PLANT(t.mesh = 0.02; t.wall_speed = 3000; t.dt = 1e-6; t.impact_speed = 1, DEM_SEVERITY_ERROR,
              "pass through each other undetected");
        PLANT(t.spare_material = 1, DEM_SEVERITY_NOTE, "material 2 is used by no grain");
        if (demi_threads_available() < 64) PLANT(t.threads = 64, DEM_SEVERITY_NOTE, "threads is 64");
#undef PLANT
    }
    TEST("a grain too far from the origin for its digits is a note from 2e-4 of its radius on and a warning from 2e-3 "
         "on") {
        static const struct { double part; dem_severity severity; } row[3] =
            {{1e-4, (dem_severity)0}, {4e-4, DEM_SEVERITY_NOTE}, {4e-3, DEM_SEVERITY_WARNING}};
        const double digit = sizeof(dem_real) == sizeof(float) ? 1.1920929e-7 : 2.220446e-16;
        int i, k;
        for (i = 0; i < 3; i++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_world *world;
            dem_finding f[8];
            dem_severity found = (dem_severity)0;
            desc.threads = 1;
            desc.gravity = at(0, 0, -9.81);
            world = dem_world_create(&desc);
            dem_sphere_add(world, scene_material(world, 1e7, 0.5, 0.3, 0), DEM_R(1e-3),
                           at(0, -1e-3*row[i].part/digit, 0));
            for (k = dem_world_check(world, f, 8) - 1; k >= 0; k--)
                if (strstr(f[k].text, "so far from the origin")) {
                    found = f[k].severity;
                    CHECK_STR(f[k].text, "body 1 is so far");
                    CHECK_STR(f[k].text, row[i].severity == DEM_SEVERITY_NOTE ? "0.0004 of its radius"
                                                                              : "0.004 of its radius");
                }
            CHECK_EQ(found, row[i].severity);
            dem_world_destroy(world);
        }
    }
    TEST("with little room the most severe findings stay, and all are counted") {
        tray t = TRAY;
        dem_world *world;
        dem_finding f[2];
        t.density = 2.5; t.spare_material = 1; t.dt = 1e-3; t.friction = 30;
        world = tray_make(&t);
        CHECK(dem_world_check(world, f, 2) >= 4);
        CHECK_EQ(f[0].severity, DEM_SEVERITY_ERROR);
        CHECK_STR(f[0].text, "dt is 0.001 s");
        CHECK_EQ(f[1].severity, DEM_SEVERITY_WARNING);
        dem_world_destroy(world);
    }
    TEST("dem_world_check reports grains inside a closed surface only where others are outside, for any kind of wall") {
        /* with grains on both sides; all inside; all outside; on both sides of an open one; brought by a feed;
           across a face of a periodic world; where the surface has moved to; all inside and periodic along z,
           where the images of a grain are inside a profile, too; across a face, three periods from the surface */
        int kind, way;
        for (kind = 0; kind < BODIES; kind++)
            for (way = 0; way < 9; way++) {
                const int all_inside = way == 1 || way == 7;
                const dem_severity severity = kind == BODY_INSIDE_OUT ? DEM_SEVERITY_NOTE : DEM_SEVERITY_WARNING;
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_motion motion = DEM_MOTION;
                dem_vec3 centre = at(0, 0, 0);
                dem_world *world;
                dem_material m;
                char says[80];
                int in;
                desc.gravity = at(0, 0, -9.81);
                desc.domain = box_of(0, -0.1, -0.1, 0.2, 0.1, 0.1);
                if (way == 5) desc.boundary[0] = DEM_BOUNDARY_PERIODIC;
                if (way == 7) desc.boundary[2] = DEM_BOUNDARY_PERIODIC;
                if (way == 8) {
                    desc.domain = box_of(0.6, -0.1, -0.1, 0.8, 0.1, 0.1);
                    desc.boundary[0] = DEM_BOUNDARY_PERIODIC;
                }
                desc.allow_large_dt = 1;
                desc.dt = DEM_R(1e-2);
                world = dem_world_create(&desc);
                m = scene_material(world, 1e7, 0.5, 0.3, 0);
                motion.kind = DEM_MOTION_TRANSLATING;
                motion.velocity = at(3, 4, 0);
                in = body_make(world, m, kind, centre, way == 3, way == 6 ? &motion : 0);
                if (way == 6) {
                    CHECK_EQ(dem_world_step(world, 1), DEM_OK);
                    centre = at(0.03, 0.04, 0);
                }
                if (way == 8) centre = at(0.6, 0, 0);
                if (way != 2 && way != 4) body_grains(world, m, centre, 0);
                if (!all_inside) body_grains(world, m, centre, 1);
                if (way == 4) {
                    dem_feed_desc feed = DEM_FEED_DESC;
                    feed.material = m;
                    feed.class_count = 1; feed.radius[0] = DEM_R(1e-4); feed.amount[0] = 10; feed.limited = 1;
                    feed.box = box_of(0.004, 0.004, -0.005, 0.03, 0.006, 0.005);
                    CHECK(dem_feed_add(world, &feed).id > 0);
                }
                snprintf(says, sizeof says, "%d of 32 grains begin inside wall 1, a closed %s", in, kind == BODY_PROFILE
                         ? "profile" : kind >= BODY_CAN ? "surface of revolution" : kind == BODY_INSIDE_OUT
                         ? "mesh with normals inwards" : "mesh with normals outwards");
                if (way == 4) strcpy(says, "feed 1 inserts grains inside wall 1");
                else if (all_inside ? in == 27 : way == 2 || way == 3) strcpy(says, "inside wall");
                else if (all_inside) strcpy(says, "24 of 27 grains begin inside wall 1");
                CHECK_EQ(body_findings(world, says, severity),
                         all_inside ? in != 27 : way != 2 && way != 3);
                dem_world_destroy(world);
            }
    }
    TEST("dem_world_check reports grains that rest without a force only if nothing moves them") {
        int k;
        for (k = 0; k < MOVES; k++) {
            dem_world *world = rest(k);
            const int found = body_findings(world, "all grains rest", DEM_SEVERITY_WARNING);
            CHECK_EQ(found, k == MOVED_NOT);
            if (found != (k == MOVED_NOT)) printf("        moved by %d\n", k);
            dem_world_destroy(world);
        }
    }
    TEST("dem_world_check reports grains that fall for ever only without joints, rails and outflow faces") {
        int k;
        for (k = 0; k < HOLDS; k++) {
            dem_world *world = hung(k);
            const int found = body_findings(world, "fall for ever", DEM_SEVERITY_WARNING);
            CHECK_EQ(found, k == HELD_NOT);
            if (found != (k == HELD_NOT)) printf("        held by %d\n", k);
            dem_world_destroy(world);
        }
    }
    TEST("dem_world_check reports bodies of a joint that overlap only if they collide") {
        int k;
        for (k = 0; k < BARS; k++) {
            dem_world *world = scissors(k);
            const int found = body_findings(world, "bodies 1 and 2 by", DEM_SEVERITY_ERROR);
            CHECK_EQ(found, k != BARS_HINGED);
            if (found != (k != BARS_HINGED)) printf("        way %d\n", k);
            dem_world_destroy(world);
        }
    }
    TEST("dem_world_check names what helps: gravity in the plane of a planar world, the modulus for Hertz's law") {
        int planar;
        for (planar = 0; planar < 2; planar++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_material_desc stuff = scene_stuff(1e6, 0.5, 0, 0);
            dem_world *world;
            dem_material m;
            desc.planar = planar;
            desc.gravity = at(0, 0, -9.81);
            desc.impact_speed = 10;
            stuff.stiffness = DEM_R(1e5);               /* Hertz's law does not use it */
            world = dem_world_create(&desc);
            m = dem_material_add(world, &stuff);
            dem_wall_plane_add(world, m, at(0, 0, 0), planar ? at(0, 1, 0) : at(0, 0, 1));
            dem_sphere_add(world, m, DEM_R(0.01), planar ? at(0, 0.01, 0) : at(0, 0, 0.01));
            CHECK_EQ(body_findings(world, "neither gravity in the plane nor a force field: set gravity (0, -9.81, 0 m/s2)",
                                   DEM_SEVERITY_WARNING), planar);
            CHECK_EQ(body_findings(world, "m/s; a Young's modulus of", DEM_SEVERITY_WARNING), 1);
            CHECK_EQ(body_findings(world, "a stiffness of", DEM_SEVERITY_WARNING), 0);
            dem_world_destroy(world);
        }
    }
    return test_end();
}
