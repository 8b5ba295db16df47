/* Fixed polyhedra that touch: other bodies feel one surface. Spheres, ellipsoids and clusters slide over floors of fixed boxes as on a
   single one, boxes and rocks by springs as on a mesh of the same outline, by impulses as on a single box. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const int wide = sizeof(dem_real) == sizeof(double);
enum { BALL, EGG, CLUMP, BOX, ROCK, BODIES };
static const char *const body_name[BODIES] = {"ball", "ellipsoid", "cluster", "box", "rock"};
/* One box; ten of one size; of different sizes; two rows of unequal lengths; a mesh. All are flush at z = 0. */
enum { ONE, TEN, UNLIKE, ROWS, MESH, FLOORS };

static dem_body block(dem_world *w, dem_material m, double x0, double x1, double y0, double y1, double depth) {
    const dem_body b = dem_body_add(w, m, scene_box(w, x1 - x0, y1 - y0, depth), at((x0 + x1)/2, (y0 + y1)/2, -depth/2),
                                    dem_quat_make(1, 0, 0, 0));
    dem_body_state s = scene_state(w, b);
    s.fixed = 1;
    CHECK_EQ(dem_body_set(w, b, &s), DEM_OK);
    return b;
}
static void mesh_add(dem_world *w, dem_material m) {
    static int32_t f[36] = {0,2,1, 1,2,3, 4,5,6, 5,7,6, 0,1,4, 1,5,4, 2,6,3, 3,6,7, 0,4,2, 2,4,6, 1,3,5, 3,7,5};
    dem_real p[24];
    dem_mesh q;
    int i;
    scene_box_points(2, 0.4, 0.2, p);
    for (i = 0; i < 8; i++) { p[3*i] += DEM_R(0.8); p[3*i + 2] -= DEM_R(0.1); }
    q.vertex_count = 8;
    q.triangle_count = 12;
    q.vertices = p;
    q.triangles = f;
    CHECK(dem_wall_mesh_add(w, m, &q).id > 0);
}
static void floor_add(dem_world *w, dem_material m, int kind) {
    static const double length[8] = {0.3, 0.11, 0.25, 0.07, 0.4, 0.13, 0.2, 0.54};
    double x = -0.2;
    int i;
    if (kind == ONE) block(w, m, -0.2, 1.8, -0.2, 0.2, 0.2);
    if (kind == MESH) mesh_add(w, m);
    for (i = 0; i < 10 && kind == TEN; i++) block(w, m, -0.2 + 0.2*i, 0.2*i, -0.2, 0.2, 0.2);
    for (i = 0; i < 8 && kind >= UNLIKE && kind != MESH; i++) {
        block(w, m, x, x + length[i], -0.2, kind == ROWS ? 0.03 : 0.2, 0.15 + 0.05*(i%3));
        x += length[i];
    }
    for (i = 0; i < 5 && kind == ROWS; i++) block(w, m, -0.2 + 0.4*i, 0.2 + 0.4*i, 0.03, 0.2, 0.3);
}
static dem_body body_add(dem_world *w, dem_material m, int body) {
    static const double corner[15] = {-0.05, -0.04, -0.03, 0.05, -0.03, -0.03, 0.03, 0.05, -0.03, -0.04, 0.04, -0.03, 0.01, 0, 0.05};
    static const double ball[9] = {-0.04, 0, 0, 0.04, 0, 0, 0, 0.05, 0};
    const dem_quat up = dem_quat_make(1, 0, 0, 0);
    dem_cluster_desc c = DEM_CLUSTER_DESC;
    dem_real p[15], x[9];
    int i;
    if (body == BALL) return dem_sphere_add(w, m, DEM_R(0.05), at(0.013, 0.02, 0.05));
    if (body == EGG) return dem_body_add(w, m, dem_shape_ellipsoid_add(w, at(0.06, 0.05, 0.04)), at(0.013, 0.02, 0.04), up);
    if (body == BOX) return dem_body_add(w, m, scene_box(w, 0.1, 0.08, 0.06), at(0.013, 0.02, 0.03), up);
    for (i = 0; i < 15; i++) p[i] = (dem_real)corner[i];
    if (body == ROCK) return dem_body_add(w, m, dem_shape_polyhedron_add(w, 5, p), at(0.013, 0.02, 0.02), up);
    for (i = 0; i < 9; i++) x[i] = (dem_real)ball[i];
    c.count = 3;
    c.positions = x;
    c.radius = DEM_R(0.03);
    return dem_body_add(w, m, dem_shape_cluster_add(w, &c), at(0.013, 0.02, 0.03), up);
}
/* last: the floor is added after the body. */
static dem_world *scene(int kind, int body, int impulses, double friction, int last, dem_body *b) {
    dem_world_desc d = DEM_WORLD_DESC;
    dem_world *w;
    dem_material m;
    d.gravity.z = DEM_R(-9.81);
    d.cluster_contacts = DEM_CLUSTER_CONTACTS_SEPARATE;
    d.response = impulses ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS;
    d.dt = impulses ? DEM_R(1e-3) : DEM_R(1.5e-5);
    d.tolerance = impulses ? DEM_R(1e-9) : 0;
    d.sweeps = impulses ? 20000 : 0;
    w = dem_world_create(&d);
    m = scene_material(w, 5e8, 0.5, friction, 0);
    if (!last) floor_add(w, m, kind);
    *b = body_add(w, m, body);
    if (last) floor_add(w, m, kind);
    scene_move(w, *b, at(friction > 0 ? 1.5 : 0.5, 0.05, 0), at(0, 0, 0));
    return w;
}
static dem_body_state slid(int kind, int body, int impulses, double friction, int last) {
    dem_body b;
    dem_world *w = scene(kind, body, impulses, friction, last, &b);
    dem_body_state s;
    CHECK_EQ(scene_step(w, impulses ? 1000 : 60000), DEM_OK);
    s = scene_state(w, b);
    dem_world_destroy(w);
    return s;
}
/* Largest difference of velocities, m/s, and of rim speeds. */
static double apart(dem_body_state a, dem_body_state b) {
    return (double)demi_length(demi_sub(a.velocity, b.velocity)) + 0.05*(double)demi_length(demi_sub(a.spin, b.spin));
}
static void table(int impulses) {
    int body, kind, rough, last;
    for (body = 0; body < BODIES; body++)
        for (rough = 0; rough < 2; rough++) {
            const int sharp = body >= BOX;
            const dem_body_state one = slid(sharp && !impulses ? MESH : ONE, body, impulses, 0.3*rough, 0);
            const double most = !wide ? 1e-3 : sharp ? (impulses ? 1e-4 : rough ? 1e-6 : 1e-8) : rough ? 1e-7 : 1e-9;
            if (getenv("TEST_TABLES")) printf("    %-9s %-8s friction %.1f:", body_name[body], impulses ? "impulses" : "springs", 0.3*rough);
            for (kind = TEN; kind <= ROWS; kind++)
                for (last = 0; last < 2; last++) {
                    const double off = apart(slid(kind, body, impulses, 0.3*rough, last), one);
                    if (getenv("TEST_TABLES")) printf(" %8.1e", off);
                    CHECK_NEAR(off, 0, most);
                }
            if (getenv("TEST_TABLES")) printf("\n");
        }
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("by springs bodies slide over fixed boxes side by side as on one surface") table(0);
    TEST("by impulses bodies slide over fixed boxes side by side as on one surface") table(1);
    return test_end();
}
