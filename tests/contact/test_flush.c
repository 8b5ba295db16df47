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
    d.dt = impulses ? DEM_R(1e-3) : DEM_R(3.5e-5);
    d.tolerance = impulses ? DEM_R(1e-9) : 0;
    d.sweeps = impulses ? 20000 : 0;
    w = dem_world_create(&d);
    m = scene_material(w, 5e7, 0.5, friction, 0);
    if (!last) floor_add(w, m, kind);
    *b = body_add(w, m, body);
    if (last) floor_add(w, m, kind);
    scene_move(w, *b, at(friction > 0 ? 1.5 : 1.2, 0.05, 0), at(0, 0, 0));
    return w;
}
static dem_body_state slid(int kind, int body, int impulses, double friction, int last) {
    dem_body b;
    dem_world *w = scene(kind, body, impulses, friction, last, &b);
    dem_body_state s;
    CHECK_EQ(scene_step(w, impulses ? 600 : 13000), DEM_OK);
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
            const double most = !wide ? 5e-3 : sharp ? (impulses ? 1e-4 : rough ? 1e-5 : 1e-8) : rough ? 1e-7 : 1e-9;
            if (getenv("TEST_TABLES")) printf("    %-9s %-8s friction %.1f:", body_name[body], impulses ? "impulses" : "springs", 0.3*rough);
            for (kind = TEN; kind <= ROWS; kind++)
                for (last = 0; last < (kind == TEN ? 2 : 1); last++) {
                    const double off = apart(slid(kind, body, impulses, 0.3*rough, last), one);
                    if (getenv("TEST_TABLES")) printf(" %8.1e", off);
                    CHECK_NEAR(off, 0, most);
                }
            if (getenv("TEST_TABLES")) printf("\n");
        }
}

/* A box that is periodic along x, with a floor of ten blocks around; bodies of all kinds slide over it, each on its own track. */
enum { TRACKS = 4 };
static dem_world *ring(dem_body *b) {
    static const int bodies[TRACKS] = {BALL, EGG, CLUMP, BOX};
    dem_world_desc d = DEM_WORLD_DESC;
    dem_world *w;
    dem_material m;
    int i, k;
    d.gravity.z = DEM_R(-9.81);
    d.cluster_contacts = DEM_CLUSTER_CONTACTS_SEPARATE;
    d.dt = DEM_R(3.5e-5);
    d.domain = box_of(-0.2, -1, -1, 1.8, 2, 1);
    d.boundary[0] = DEM_BOUNDARY_PERIODIC;
    w = dem_world_create(&d);
    m = scene_material(w, 5e7, 0.5, 0, 0);
    for (i = 0; i < 10; i++)
        for (k = 0; k < TRACKS; k++) block(w, m, -0.2 + 0.2*i, 0.2*i, 0.3*k - 0.1, 0.3*k + 0.2, 0.2);
    for (k = 0; k < TRACKS; k++) {
        dem_body_state s;
        b[k] = body_add(w, m, bodies[k]);
        s = scene_state(w, b[k]);
        s.position.y += DEM_R(0.3)*(dem_real)k;
        s.position.x += DEM_R(1.4);
        s.velocity = at(2, 0, 0);
        CHECK_EQ(dem_body_set(w, b[k], &s), DEM_OK);
    }
    return w;
}
static void around(void) {
    dem_body b[TRACKS];
    dem_world *w = ring(b);
    int k, count;
    CHECK_EQ(scene_step(w, 22000), DEM_OK);
    for (k = 0; k < TRACKS; k++) {
        CHECK_NEAR(scene_state(w, b[k]).velocity.x, 2, wide ? 1e-9 : 1e-4);
        CHECK_NEAR(demi_length(scene_state(w, b[k]).spin), 0, wide ? 1e-9 : 1e-3);
    }
    for (count = 2; count < 4; count++) {
        dem_body c[TRACKS];
        dem_world *other = ring(c);
        dem_slabs_desc desc = DEM_SLABS_DESC;
        dem_slabs *slabs;
        desc.count = count;
        slabs = dem_slabs_create(other, &desc);
        CHECK_EQ(dem_slabs_step(slabs, 22000), DEM_OK);
        CHECK_EQ(dem_slabs_collect(slabs, other), DEM_OK);
        for (k = 0; k < TRACKS; k++)
            CHECK_NEAR(apart(scene_state(other, c[k]), scene_state(w, b[k])), 0, wide ? 1e-9 : 1e-3);
        dem_slabs_destroy(slabs);
        dem_world_destroy(other);
    }
    dem_world_destroy(w);
}
/* The forces on two boxes, N, on whose seam a body rests. */
static void shared(int body, int impulses) {
    dem_world_desc d = DEM_WORLD_DESC;
    dem_world *w;
    dem_material m;
    dem_body b, one, two;
    dem_body_state s;
    d.gravity.z = DEM_R(-9.81);
    d.response = impulses ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS;
    d.dt = impulses ? DEM_R(1e-3) : DEM_R(3.5e-5);
    w = dem_world_create(&d);
    m = scene_material(w, 5e7, 0.5, 0, 0);
    one = block(w, m, -0.2, 0, -0.2, 0.2, 0.2);
    two = block(w, m, 0, 0.3, -0.2, 0.2, 0.1);
    b = body_add(w, m, body);
    s = scene_state(w, b);
    s.position.x = 0;
    CHECK_EQ(dem_body_set(w, b, &s), DEM_OK);
    CHECK_EQ(scene_step(w, impulses ? 400 : 20000), DEM_OK);
    s = scene_state(w, b);
    CHECK_NEAR(s.force.z, s.mass*DEM_R(9.81), 1e-3*(double)s.mass);
    CHECK_NEAR(scene_state(w, one).force.z + scene_state(w, two).force.z, -s.force.z, 1e-4*(double)s.mass);
    if (body == BOX && !impulses) CHECK_NEAR(scene_state(w, one).force.z/scene_state(w, two).force.z, 1, wide ? 1e-6 : 1e-3);
    if (body == BOX) CHECK(scene_state(w, one).force.z < 0 && scene_state(w, two).force.z < 0);
    dem_world_destroy(w);
}
/* A ball that comes to the end of a block, where meanwhile another one was put (add) or taken away. */
static dem_body_state changed(int add, int impulses) {
    dem_world_desc d = DEM_WORLD_DESC;
    dem_world *w;
    dem_material m;
    dem_body ball, next;
    dem_body_state s;
    const int steps = impulses ? 100 : 10000;
    d.gravity.z = DEM_R(-9.81);
    d.response = impulses ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS;
    d.dt = impulses ? DEM_R(1e-3) : DEM_R(1e-5);
    w = dem_world_create(&d);
    m = scene_material(w, 5e7, 0.5, 0, 0);
    block(w, m, -0.4, 0, -0.2, 0.2, 0.2);
    memset(&next, 0, sizeof next);
    if (!add) next = block(w, m, 0, 0.3, -0.2, 0.2, 0.2);
    ball = dem_sphere_add(w, m, DEM_R(0.05), at(-0.15, 0, 0.05));
    scene_move(w, ball, at(1, 0, 0), at(0, 0, 0));
    CHECK_EQ(scene_step(w, steps), DEM_OK);
    if (add) block(w, m, 0, 0.3, -0.2, 0.2, 0.2);
    else CHECK_EQ(dem_body_remove(w, next), DEM_OK);
    CHECK_EQ(scene_step(w, 2*steps), DEM_OK);
    s = scene_state(w, ball);
    dem_world_destroy(w);
    return s;
}
/* Continues from a checkpoint while a body is on a seam. */
static void continued(int body, int impulses) {
    const char *path = "build/tmp/test_flush.dem";
    dem_body a, b;
    dem_world *w = scene(TEN, body, impulses, 0.3, 0, &a), *other = scene(TEN, body, impulses, 0.3, 0, &b);
    dem_body_state s, t;
    const int steps = impulses ? 60 : 4000;
    CHECK_EQ(scene_step(w, steps), DEM_OK);
    CHECK_EQ(dem_checkpoint_write(w, path), DEM_OK);
    CHECK_EQ(dem_checkpoint_read(other, path), DEM_OK);
    CHECK_EQ(scene_step(w, steps), DEM_OK);
    CHECK_EQ(scene_step(other, steps), DEM_OK);
    s = scene_state(w, a);
    t = scene_state(other, b);
    CHECK(!memcmp(&s.position, &t.position, sizeof s.position) && !memcmp(&s.velocity, &t.velocity, sizeof s.velocity));
    dem_world_destroy(w);
    dem_world_destroy(other);
    remove(path);
}

int main(int argc, char **argv) {
    int body, impulses;
    test_begin(argc, argv);
    TEST("by springs bodies slide over fixed boxes side by side as on one surface") table(0);
    TEST("by impulses bodies slide over fixed boxes side by side as on one surface") table(1);
    TEST("a floor of fixed boxes continues across periodic faces and borders of slabs") around();
    TEST("two fixed boxes bear the weight of a body on their seam together") {
        for (body = 0; body < BODIES; body++)
            for (impulses = 0; impulses < 2; impulses++) shared(body, impulses);
    }
    TEST("a fixed box that is put beside another, or taken away, changes their surface at once") {
        for (impulses = 0; impulses < 2; impulses++) {
            CHECK_NEAR(changed(1, impulses).velocity.x, 1, wide ? 1e-9 : 1e-4);
            CHECK(changed(0, impulses).velocity.z < -0.5);
        }
    }
    TEST("a body on the seam of fixed boxes continues from a checkpoint bit for bit") {
        for (body = 0; body < BODIES; body++)
            for (impulses = 0; impulses < 2; impulses++) continued(body, impulses);
    }
    return test_end();
}
