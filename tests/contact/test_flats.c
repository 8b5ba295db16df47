/* A polyhedron on a floor of several walls: dashpots and friction are those of one wall, however the floor is divided. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const int fine = sizeof(dem_real) == 8;       /* double precision */
static const double L = 1e-3, far = 30e-3;
enum { CUBE, ROD, ROCK, POLYGON, BODIES };
static const char *const bodies[] = {"cube", "rod", "rock", "polygon"};
enum { ONE, HALVES, QUARTERS, UNEQUAL, STRIPS, UNDER_PLANE, RIDGE, FLOORS };
static const char *const floors[] = {"one mesh", "two meshes", "four meshes", "four unequal meshes", "40 strips",
    "a plane on two meshes", "a ridge"};
enum { FLAT, TILTED, SLIDING, FALLS };
static const char *const falls[] = {"flat", "tilted", "sliding"};
enum { RESTS, TRANSLATES, ROTATES, RUNS };
static int floor_does;                               /* all walls alike; RUNS: a belt */
static const double floor_speed = 0.2;               /* m/s */
static double restitution = 0.5, friction = 0.4;

static void wall_moves(dem_world *w, dem_wall wall) {
    dem_motion m = DEM_MOTION;
    if (floor_does == RUNS) dem_wall_surface_velocity_set(w, wall, at(floor_speed, 0, 0));
    if (floor_does == RESTS || floor_does == RUNS) return;
    m.kind = floor_does == ROTATES ? DEM_MOTION_ROTATING : DEM_MOTION_TRANSLATING;
    m.velocity = at(floor_speed, 0, 0);
    m.axis = at(0, 0, 1);
    m.point = at(-2*L, 0, 0);
    m.speed = 50;
    dem_wall_motion_set(w, wall, &m);
}
static dem_real steep;                               /* slope of the floor on both sides of x = 0 */
/* The floor z = 0 (planar worlds: y = 0), divided at x and y (m) into count x rows walls or, if `one`, facets of one wall. */
static void floor_of(dem_world *w, dem_material m, int count, const double *x, int rows, const double *y, int one) {
    static dem_real v[12*40];
    static int32_t t[6*40];
    const int planar = w->desc.planar, per = planar ? 2 : 4, sides = planar ? 2 : 6, all = planar ? count : count*rows;
    int i, k;
    for (i = 0; i < all; i++) {
        static const int32_t two[6] = {0, 1, 2, 0, 2, 3};
        const int at = one ? i : 0, column = planar ? i : i/rows;
        for (k = 0; k < per; k++) {
            dem_real *p = v + (planar ? 2 : 3)*(per*at + k);
            p[0] = (dem_real)x[column + (k == 1 || k == 2)];
            if (!planar) p[1] = (dem_real)y[i%rows + k/2];
            if (!planar) p[2] = steep*DEMI_ABS(p[0]);
            else p[1] = steep*DEMI_ABS(p[0]);
        }
        for (k = 0; k < sides; k++) t[sides*at + k] = per*at + two[k];
        if (one && i < all - 1) continue;
        if (planar) {
            dem_profile p;
            p.vertices = v; p.vertex_count = 2*(at + 1);
            p.segments = t; p.segment_count = at + 1;
            wall_moves(w, dem_wall_profile_add(w, m, &p, DEM_EDGE_RESOLVED));
        } else {
            dem_mesh q;
            q.vertices = v; q.vertex_count = 4*(at + 1);
            q.triangles = t; q.triangle_count = 2*(at + 1);
            wall_moves(w, dem_wall_mesh_add(w, m, &q));
        }
    }
}
static void floor_add(dem_world *w, dem_material m, int floor, int one) {
    const double half[3] = {-far, 0, far}, odd[3] = {-far, 0.31*L, far}, whole[2] = {-far, far}, even[3] = {-far, -0.17*L, far};
    double strip[41];
    int i;
    for (i = 0; i < 41; i++) strip[i] = i && i < 40 ? (i - 20)*0.37*L : i ? far : -far;
    steep = floor == RIDGE ? DEM_R(-0.05) : 0;
    switch (floor) {
    case RIDGE: case HALVES: floor_of(w, m, 2, half, 1, whole, one); break;
    case QUARTERS: floor_of(w, m, 2, half, 2, half, one); break;
    case UNEQUAL: floor_of(w, m, 2, odd, 2, even, one); break;
    case STRIPS: floor_of(w, m, 40, strip, 1, whole, one); break;
    case UNDER_PLANE:
        wall_moves(w, dem_wall_plane_add(w, m, at(0, 0, 0), w->desc.planar ? at(0, 1, 0) : at(0, 0, 1)));
        floor_of(w, m, 2, half, 1, whole, one); break;
    default: floor_of(w, m, 1, whole, 1, whole, 1);
    }
}
static dem_shape shape_of(dem_world *w, int body) {
    const dem_real four[8] = {DEM_R(-1e-3), DEM_R(-1e-3), DEM_R(1e-3), DEM_R(-1e-3), DEM_R(1e-3), DEM_R(1e-3), DEM_R(-1e-3),
                              DEM_R(0.8e-3)};
    uint64_t seed = 7;
    switch (body) {
    case ROD: return scene_box(w, 4*L, 1.2*L, L);
    case ROCK: return scene_rock(w, &seed, 20, L);
    case POLYGON: return dem_shape_polygon_add(w, 4, four);
    default: return scene_box(w, 2*L, 2*L, 2*L);
    }
}
/* one: 1: the same facets in one wall. */
static dem_world *fall_world(int body, int floor, int one, int fall, int impulses, dem_body *b) {
    dem_world_desc d = DEM_WORLD_DESC;
    dem_world *w;
    dem_material m;
    dem_vec3 speed, spin = at(0, 0, 0);
    const dem_quat lean = body == POLYGON ? dem_quat_make(DEM_R(0.99), 0, 0, DEM_R(0.141067359796659))
        : dem_quat_make(DEM_R(0.98), DEM_R(0.1), DEM_R(0.14), DEM_R(0.0994987437106620));
    const double height[BODIES][2] = {{1, 1.5}, {0.5, 1.4}, {1.05, 1.05}, {1, 1.5}}, y = 0.1*L;
    const double high = height[body][fall == TILTED]*L;
    d.planar = body == POLYGON;
    d.gravity = d.planar ? at(0, -9.81, 0) : at(0, 0, -9.81);
    d.impact_speed = 1;
    if (impulses) d.response = DEM_RESPONSE_IMPULSES;
    d.dt = impulses ? DEM_R(1e-5) : DEM_R(2e-6);
    w = dem_world_create(&d);
    m = scene_material(w, d.planar ? 5e9 : 5e6, restitution, friction, 0);      /* polygons are 1 m long */
    w->facets_given = impulses;
    floor_add(w, m, floor, one);
    *b = dem_body_add(w, m, shape_of(w, body), d.planar ? at(0.1*L, high, 0) : at(0.1*L, y, high),
                      fall == TILTED ? lean : dem_quat_make(1, 0, 0, 0));
    speed = fall == SLIDING ? at(-0.4, 0.1, -0.05) : at(0.1, 0, -0.5);
    if (fall == TILTED) spin = d.planar ? at(0, 0, 20) : at(20, -30, 10);
    if (d.planar) speed = at((double)speed.x, (double)speed.z, 0);
    scene_move(w, *b, floor_does == TRANSLATES ? demi_add(speed, at(floor_speed, 0, 0)) : speed, spin);
    CHECK_STR(dem_world_error_get(w), "");
    return w;
}
typedef struct gap { double way, speed, spin, load; } gap;
/* Force and torque of the body on all walls, about the origin; N, Nm over L. */
static void load_of(const dem_world *w, double *out) {
    int i, k;
    for (k = 0; k < 6; k++) out[k] = 0;
    for (i = 0; i < w->wall_count; i++) {
        dem_wall wall;
        dem_wall_loads l;
        dem_vec3 moment;
        wall.id = w->walls[i].id;
        dem_wall_loads_get(w, wall, &l);
        moment = demi_add(l.torque, demi_cross(w->walls[i].motion.point, l.force));
        out[0] += (double)l.force.x; out[1] += (double)l.force.y; out[2] += (double)l.force.z;
        out[3] += (double)moment.x/L; out[4] += (double)moment.y/L; out[5] += (double)moment.z/L;
    }
}
/* The largest differences between a floor and one mesh, over L, 0.5 m/s, 0.5 m/s over L, and the largest force. */
static gap gap_of(int body, int floor, int fall, int impulses) {
    gap most = {0, 0, 0, 0};
    double peak = 0, load = 0, x[6], y[6];
    dem_body a, b;
    dem_world *one = fall_world(body, impulses || floor == RIDGE ? floor : ONE, 1, fall, impulses, &a);
    dem_world *w = fall_world(body, floor, 0, fall, impulses, &b);
    int step, k;
    for (step = 0; step < 200; step++) {
        dem_body_state s, t;
        CHECK_EQ(dem_world_step(one, impulses ? 10 : 25), DEM_OK);
        CHECK_EQ(dem_world_step(w, impulses ? 10 : 25), DEM_OK);
        s = scene_state(one, a);
        t = scene_state(w, b);
        most.way = fmax(most.way, (double)demi_length(demi_sub(s.position, t.position))/L);
        most.speed = fmax(most.speed, (double)demi_length(demi_sub(s.velocity, t.velocity))/0.5);
        most.spin = fmax(most.spin, (double)demi_length(demi_sub(s.spin, t.spin))*L/0.5);
        load_of(one, x);
        load_of(w, y);
        for (k = 0; k < 6; k++) { load = fmax(load, fabs(x[k] - y[k])); peak = fmax(peak, fabs(x[k])); }
    }
    CHECK(peak > 0 || impulses);                /* these load walls only in steps with an impact */
    most.load = peak > 0 ? load/peak : 0;
    dem_world_destroy(one);
    dem_world_destroy(w);
    return most;
}
static double table_of(int impulses, double limit) {
    double worst = 0;
    int body, floor, fall;
    for (body = 0; body < BODIES; body++)
        for (floor = HALVES; floor < FLOORS; floor++)
            for (fall = 0; fall < FALLS; fall++) {
                const gap q = gap_of(body, floor, fall, impulses);
                const double over = fmax(fmax(q.way, q.speed), fmax(q.spin, q.load));
                if (over > limit)
                    printf("    a %s, %s, on %s by %s: way %.3g, speed %.3g, spin %.3g, load %.3g\n", bodies[body], falls[fall],
                           floors[floor], impulses ? "impulses" : "springs", q.way, q.speed, q.spin, q.load);
                worst = fmax(worst, over);
            }
    return worst;
}
/* Weight of the pressure of a cube's face that lies `deep` (over L) in the floor, where x < edge, and its centre. The pressure
   is the least of those of all faces. */
static double press_of(double deep, double edge, double *centre) {
    const int n = 4000;
    double all = 0, left = 0;
    int i;
    *centre = 0;
    for (i = 0; i < n; i++) {
        const double x = (i + 0.5)*2/n - 1, u = fmin(deep, 1 - fabs(x));
        const double p = 2*u*(1 - u) + u*u;     /* over y, by sides of a trapezium */
        all += p;
        if (x < edge) { left += p; *centre += p*x; }
    }
    *centre /= left;
    return left/all;
}
int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("by springs a polyhedron falls on, and slides over, several walls as it does on one")
        CHECK_NEAR(table_of(0, fine ? 1e-11 : 1e-3), 0, fine ? 1e-11 : 1e-3);
    TEST("by impulses a polyhedron falls on, and slides over, several walls as on one with the same facets")
        CHECK_NEAR(table_of(1, fine ? 1e-11 : 1e-3), 0, fine ? 1e-11 : 1e-3);
    TEST("a cube on walls that move together, or are one belt, moves as on one wall") {
        for (floor_does = TRANSLATES; floor_does <= RUNS; floor_does++) {
            int fall;
            for (fall = 0; fall < FALLS; fall++) {
                const gap q = gap_of(CUBE, UNEQUAL, fall, 0);
                CHECK_NEAR(fmax(fmax(q.way, q.speed), fmax(q.spin, q.load)), 0, fine ? 1e-11 : 1e-3);
            }
        }
        floor_does = RESTS;
    }
    TEST("each of two walls below a cube has the force and the torque of its own pressure") {
        dem_body b;
        dem_world *w;
        dem_body_state s;
        dem_wall first, second;
        dem_wall_loads l, r;
        double x, part;
        friction = 0;
        restitution = 1;
        w = fall_world(CUBE, HALVES, 0, FLAT, 0, &b);
        dem_world_step(w, 200);
        s = scene_state(w, b);
        part = press_of(1 - (double)s.position.z/L, -(double)s.position.x/L, &x);
        x = x*L + (double)s.position.x;
        first.id = 1;
        second.id = 2;
        dem_wall_loads_get(w, first, &l);
        dem_wall_loads_get(w, second, &r);
        CHECK_NEAR((double)(l.force.z/(l.force.z + r.force.z)), part, 1e-4);
        CHECK_NEAR((double)(-l.torque.y/l.force.z)/L, x/L, 1e-4);
        dem_world_destroy(w);
        w = fall_world(CUBE, RIDGE, 0, FLAT, 0, &b);
        dem_world_step(w, 200);
        dem_wall_loads_get(w, first, &l);
        dem_wall_loads_get(w, second, &r);
        CHECK(l.force.z < 0 && r.force.z < 0);
        CHECK_NEAR((double)(l.force.x/l.force.z), -0.05, fine ? 1e-12 : 1e-5);
        CHECK_NEAR((double)(r.force.x/r.force.z), 0.05, fine ? 1e-12 : 1e-5);
        dem_world_destroy(w);
        friction = 0.4;
        restitution = 0.5;
    }
    return test_end();
}
