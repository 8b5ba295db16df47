/* dem_world_check: names what was planted in a scene that is right otherwise, and is silent on scenes of practice. */
#define DEM_IMPLEMENTATION
#include "../dem.h"
#include "test.h"
#include "scene.h"

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
    if (t->floor) dem_plane_add(world, m, at(0, 0, 0), at(0, 0, t->normal_up ? 1 : -1));
    dem_plane_add(world, m, at(-r, 0, 0), at(1, 0, 0));
    dem_plane_add(world, m, at(0, -r, 0), at(0, 1, 0));
    if (t->mesh > 0) {
        dem_wall wall = scene_floor(world, m, 0, 0, t->mesh, t->mesh, 2, 2);
        dem_motion motion = DEM_MOTION;
        motion.kind = DEM_MOTION_TRANSLATING;
        motion.velocity = at(t->wall_speed, 0, 0);
        if (t->wall_speed > 0) dem_wall_motion(world, wall, &motion);
    }
    if (t->hidden) {
        dem_mesh mesh;
        dem_real p[9] = {0, 0, -1, DEM_R(0.01), 0, -1, 0, DEM_R(0.01), -1};
        int32_t c[3] = {0, 1, 2};
        mesh.vertex_count = 3; mesh.triangle_count = 1; mesh.vertices = p; mesh.triangles = c;
        dem_mesh_add(world, m, &mesh);
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

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("a scene without a mistake has no finding, and looking changes no bit of its run") {
        dem_world *a = tray_make(&TRAY), *b = tray_make(&TRAY);
        dem_finding f;
        CHECK_EQ(tray_check(&TRAY, DEM_SEVERITY_NOTE, 0), 0);
        CHECK_EQ(scene_step(a, 500), DEM_OK);
        CHECK_EQ(dem_world_check(b, &f, 1), 0);
        CHECK_EQ(scene_step(b, 250), DEM_OK);
        CHECK_EQ(dem_world_check(b, 0, 0), 0);
        CHECK_EQ(scene_step(b, 250), DEM_OK);
        CHECK(dem_world_hash(a) == dem_world_hash(b));
        dem_world_destroy(a);
        dem_world_destroy(b);
        CHECK_EQ(dem_world_check(0, &f, 1), 0);
    }
    TEST("each of 24 mistakes that were planted in it is named, with its value") {
#define PLANT(change, severity, says) do { tray t = TRAY; change; CHECK(tray_check(&t, severity, says) > 0); } while (0)
        PLANT(t.grains = 0, DEM_SEVERITY_ERROR, "no grain moves, and no feed brings any");
        PLANT(t.gravity = 0, DEM_SEVERITY_WARNING, "neither gravity nor a force");
        PLANT(t.floor = 0, DEM_SEVERITY_WARNING, "they fall for ever");
        PLANT(t.gravity = 9.81, DEM_SEVERITY_WARNING, "gravity is (0, 0, 9.81) m/s2");
        PLANT(t.radius = 2; t.drop = 4, DEM_SEVERITY_WARNING, "was 2 mm meant?");
        PLANT(t.radius = 5e-8; t.drop = 1e-7, DEM_SEVERITY_WARNING, "radius of 5e-08 m");
        PLANT(t.density = 2.5, DEM_SEVERITY_WARNING, "was 2.5 g/cm3 meant?");
        PLANT(t.young = 70; t.dt = 1e-5, DEM_SEVERITY_WARNING, "Young's modulus of 70 Pa");
        PLANT(t.friction = 30, DEM_SEVERITY_WARNING, "tan of 30 degrees is 0.577");
        PLANT(t.rolling = 20, DEM_SEVERITY_WARNING, "rolling friction of 20");
        PLANT(t.mesh = 300, DEM_SEVERITY_WARNING, "wall 4, a mesh, is 300 m long");
        PLANT(t.mesh = 1e-4, DEM_SEVERITY_WARNING, "is it in other units?");
        PLANT(t.hidden = 1, DEM_SEVERITY_WARNING, "nothing can reach it");
        PLANT(t.normal_up = 0, DEM_SEVERITY_ERROR, "grains begin in walls");
        PLANT(t.drop = -0.0005, DEM_SEVERITY_WARNING, "body 1 in wall 1 by 0.5");
        PLANT(t.inside = 1, DEM_SEVERITY_ERROR, "bodies 1 and 61 by");
        PLANT(t.outflow = 2, DEM_SEVERITY_WARNING, "1 grain is outside the domain");
        PLANT(t.dt = 1e-3, DEM_SEVERITY_ERROR, "dt is 0.001 s, more than");
        PLANT(t.dt = 1e-9, DEM_SEVERITY_NOTE, "times smaller than need be");
        PLANT(t.impact_speed = 20, DEM_SEVERITY_WARNING, "of their radius at 20 m/s");
        PLANT(t.heavy = 1; t.young = 1e5, DEM_SEVERITY_WARNING, "N each");
        PLANT(t.mesh = 0.02; t.wall_speed = 3000; t.dt = 1e-6; t.impact_speed = 1, DEM_SEVERITY_ERROR,
              "pass each other unseen");
        PLANT(t.spare_material = 1, DEM_SEVERITY_NOTE, "material 2 is used by no grain");
        if (demi_threads_available() < 64) PLANT(t.threads = 64, DEM_SEVERITY_NOTE, "threads is 64");
#undef PLANT
    }
    TEST("a grain so far from the origin that its place has too few digits is named, as a note from 2e-4 of its "
         "radius on and as a warning from 2e-3 on") {
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
    TEST("the most severe findings are kept where there is room for few, and counted all") {
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
    return test_end();
}
