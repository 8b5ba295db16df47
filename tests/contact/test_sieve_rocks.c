/* Convex polyhedra on sieves: elastic rocks on every kind keep their energy; gaps are those of points all over their
   faces; what is smaller than a hole goes through it, what is larger stays; blocks slide, wedges get stuck. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const int fine = sizeof(dem_real) == 8;
static const double earth = 9.81;                   /* m/s2 */
static const dem_quat straight = {1, 0, 0, 0};
enum { WEAVE = 0, LAID, BARS, SQUARE, SLOTS, ENDLESS, ROUND, STAGGERED, SORTS };
/* Holes of a between bars of b, m: plates are as thick as b. */
static dem_sieve_desc sieve_of(int sort, double a, double b) {
    static const dem_sieve_kind kinds[SORTS] = {DEM_SIEVE_WIRES, DEM_SIEVE_WIRES, DEM_SIEVE_BARS, DEM_SIEVE_SQUARE,
                                                DEM_SIEVE_SLOTS, DEM_SIEVE_SLOTS, DEM_SIEVE_ROUND, DEM_SIEVE_ROUND};
    dem_sieve_desc s = DEM_SIEVE_DESC;
    s.kind = kinds[sort];
    s.aperture = (dem_real)a;
    s.bar = (dem_real)b;
    if (sort >= SQUARE) s.thickness = (dem_real)b;
    if (sort == LAID) s.lift = (dem_real)b;
    if (sort == SLOTS) s.length = (dem_real)(2.5*a);
    if (sort == STAGGERED) s.staggered = 1;
    return s;
}
/* How far its top is above its middle, m. */
static double top_of(int sort, double b) { return sort == LAID ? b : b/2; }
static dem_world *world_of(int impulses, double gravity, double young, double restitution, double friction, double dt,
                           dem_material *m) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = scene_stuff(impulses ? 0 : young, restitution, friction, 0);
    dem_world *w;
    desc.gravity.z = (dem_real)-gravity;
    desc.response = impulses ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS;
    desc.dt = (dem_real)dt;
    desc.allow_large_dt = !impulses;
    desc.ledger = 1;
    desc.threads = 1;
    if (impulses) {
        desc.tolerance = fine ? DEM_R(1e-9) : DEM_R(1e-6);
        desc.sweeps = fine ? 20000 : 500;
    }
    w = dem_world_create(&desc);
    *m = dem_material_add(w, &stuff);
    return w;
}
static double energy(const dem_world *w) {
    const dem_ledger l = dem_ledger_get(w);
    const dem_totals t = dem_totals_get(w);
    return l.kinetic + l.rotational + l.elastic + earth*t.mass*t.centre[2];
}
static void box_around(dem_world *w, dem_material m, double half, double low, double high) {
    int i;
    dem_wall_plane_add(w, m, at(0, 0, low), at(0, 0, 1));
    dem_wall_plane_add(w, m, at(0, 0, high), at(0, 0, -1));
    for (i = 0; i < 4; i++) {
        const double side = i & 1 ? half : -half, n = i & 1 ? -1 : 1;
        dem_wall_plane_add(w, m, i < 2 ? at(side, 0, 0) : at(0, side, 0), i < 2 ? at(n, 0, 0) : at(0, n, 0));
    }
}
/* Distance of a point outside of the solid of a sieve with holes at the origin, m; inside 0. */
static dem_sieve_desc meant;
static double off_sieve(const double *x) {
    const double a = (double)meant.aperture/2, q = (double)meant.bar/2, pitch = 2*(a + q), half = (double)meant.thickness/2;
    const double up = fmax(fabs(x[2]) - half, 0);
    double least = 1e300;
    int i, j, set;
    for (set = 0; set < (meant.kind == DEM_SIEVE_WIRES ? 2 : 1) && !(meant.kind >= DEM_SIEVE_SQUARE); set++)
        for (i = -3; i < 3; i++) {
            const double u = x[set] - (i + 0.5)*pitch, z = x[2] - (set ? -1 : 1)*(double)meant.lift/2;
            least = fmin(least, fmax(sqrt(u*u + z*z) - q, 0));
        }
    if (meant.kind < DEM_SIEVE_SQUARE) return least;
    for (i = -3; i <= 3; i++)
        for (j = -6; j <= 6; j++) {             /* in which hole is it, and how far from its wall */
            const double rows = meant.staggered ? pitch*sqrt(0.75) : pitch, length = (double)meant.length;
            const double u = x[0] - (length > 0 ? i*(length + 2*q) : (i + (meant.staggered && j & 1 ? 0.5 : 0))*pitch);
            const double v = x[1] - j*rows;
            double in = meant.kind == DEM_SIEVE_ROUND ? a - sqrt(u*u + v*v) : a - fabs(v);
            if (meant.kind == DEM_SIEVE_SQUARE) in = fmin(in, a - fabs(u));
            if (meant.kind == DEM_SIEVE_SLOTS && length > 0) in = fmin(in, length/2 - fabs(u));
            if (in > 0) return sqrt(in*in + up*up);
        }
    return up;
}
/* The least gap of a body at x to the sieve that is meant, by what contacts are made of; n: its normal. */
static double least_gap(const dem_world *w, dem_shape shape, dem_quat q, dem_vec3 x, dem_vec3 *n) {
    static const int axes[3][3] = {{0, 1, 2}, {2, 0, 1}, {1, 2, 0}};       /* plate; wires of either set */
    static demi_flats flats;
    static demi_gaps gaps;
    static demi_solid s;
    const int wires = meant.kind < DEM_SIEVE_SQUARE;
    const demi_part part = scene_part(w, shape, q);
    double least = 1e300;
    int set, i, k;
    for (set = 0; set < (meant.kind == DEM_SIEVE_WIRES ? 2 : 1); set++) {
        dem_real turn[9] = {0, 0, 0, 0, 0, 0, 0, 0, 0};
        demi_part local;
        for (i = 0; i < 3; i++) turn[3*axes[wires ? 1 + set : 0][i] + i] = 1;
        local = demi_part_local(turn, &part);
        demi_solid_of(&local, at(0, 0, 0), &s);
        flats.count = gaps.count = 0;
        gaps.range = 0.02;
        if (wires) demi_wires_touch(&meant, set, &s, x, (double)part.radius + gaps.range, 0, &flats, &gaps);
        else demi_plate_touch(&meant, &s, demi_d3_of(x), (double)part.radius + gaps.range, 1e-6, 0, &flats, &gaps);
        for (i = 0; i < gaps.count; i++)
            for (k = 0; k < gaps.group[i].count; k++) {
                if (!(gaps.group[i].gap[k] < least)) continue;
                least = gaps.group[i].gap[k];
                *n = demi_rotate(turn, demi_d3_real(gaps.group[i].n[k]));
            }
    }
    return least;
}
int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("sieve rocks: elastic rocks and boxes on wires, bars and plates, in holes and stuck midway conserve energy") {
        int sort;
        for (sort = 0; sort < SORTS; sort++) {
            dem_sieve_desc s = sieve_of(sort, 0.012, 0.005);
            dem_material m;
            dem_world *w = world_of(0, earth, 2e7, 1, 0, fine ? 1e-5 : 2e-5, &m);
            uint64_t random = 7;
            double before, worst = 0;
            int i, result = DEM_OK;
            s.point = at(0.003, 0.001, 0);
            s.along = at(1, 0.3, 0);
            CHECK(dem_wall_sieve_add(w, m, &s).id);
            box_around(w, m, 0.04, -0.06, 0.06);
            for (i = 0; i < 12; i++) {
                const dem_shape rock = i%2 ? scene_rock(w, &random, 20, i%4 == 1 ? 0.010 : 0.005)
                    : scene_box(w, 0.012, 0.009, 0.007);
                const dem_body b = dem_body_add(w, m, rock, at(-0.02 + 0.02*(i%3), -0.02 + 0.02*(i/3%2), i/6 ? 0.022 : 0.044),
                                                scene_turn(&random));
                scene_move(w, b, scene_at(&random, 2, -1, 2, -1, 2, -1), scene_at(&random, 80, -40, 80, -40, 80, -40));
            }
            before = energy(w);
            for (i = 0; i < 200 && result == DEM_OK; i++) {
                result = scene_step(w, fine ? 25 : 12);
                worst = fmax(worst, fabs(energy(w) - before)/before);
            }
            CHECK_EQ(result, DEM_OK);
            CHECK(worst < (fine ? 3e-5 : 2e-2));        /* the worst of 12 seeds: 1.5e-5 */
            CHECK(dem_counters_get(w).overlap_max > DEM_R(0.1));
            if (getenv("SIEVE_NUMBERS")) printf("sort %d: %g\n", sort, worst);
            dem_world_destroy(w);
        }
    }

    TEST("sieve rocks: the gap to a sieve equals that of sampled surface points, and moving out by it removes the "
         "overlap") {
        dem_material m;
        dem_world *w = world_of(1, 0, 0, 0, 0, 1e-3, &m);
        uint64_t random = 19;
        int sort, k, apart = 0, within = 0, all = 0, sheet;
        for (sort = 0; sort < SORTS; sort++)
            for (sheet = 0; sheet < 1 + (sort >= SQUARE); sheet++)
                for (k = 0; k < 40; k++) {
                    static demi_solid placed;
                    const dem_shape shape = k%2 ? scene_rock(w, &random, 12, 0.01) : scene_box(w, 0.02, 0.012, 0.008);
                    const dem_quat q = scene_turn(&random);
                    const demi_part part = scene_part(w, shape, q);
                    const dem_vec3 x = scene_at(&random, 0.02, -0.01, 0.02, -0.01, 0.03, -0.015);
                    double wanted, gap, deep;
                    dem_vec3 n, in;
                    meant = sieve_of(sort, k%3 ? 0.012 : 0.02, 0.004);
                    if (sheet) meant.thickness = 0;
                    demi_solid_of(&part, x, &placed);
                    gap = least_gap(w, shape, q, x, &n);
                    wanted = scene_sampled(&placed, off_sieve);
                    all++;
                    if (!(wanted > 2e-4)) continue;     /* samples tell no depth; a sheet passes between them */
                    apart++;
                    CHECK(gap < wanted + (sort < ROUND ? 1e-6 : 5e-5));     /* round rims: of 17 places the nearest, refined */
                    CHECK(gap > wanted - 1e-4);
                    in = demi_add(x, demi_scale(n, (dem_real)(gap + 1e-3)));
                    demi_solid_of(&part, in, &placed);
                    if (sheet || scene_sampled(&placed, off_sieve) > 0) continue;
                    within++;
                    deep = least_gap(w, shape, q, in, &n);
                    CHECK(deep < 0 && deep > -1.001e-3);
                }
        CHECK(apart > all/3 && within > all/8);
        dem_world_destroy(w);
    }

    TEST("sieve rocks: a cube smaller than the holes falls through, a larger one rests, under springs and impulses") {
        int impulses, sort, large;
        for (impulses = 0; impulses < 2; impulses++)
            for (sort = 0; sort < SORTS; sort++)
                for (large = 0; large < 2; large++) {
                    const double a = 0.012, b = 0.004, edge = large ? 1.9*a : sort >= ROUND ? 0.65*a : 0.9*a;
                    dem_sieve_desc s = sieve_of(sort, a, b);
                    dem_material m;
                    dem_world *w = world_of(impulses, earth, 1e8, 0.2, 0.3, impulses ? 1e-3 : 2e-5, &m);
                    dem_body cube;
                    double z;
                    dem_wall_sieve_add(w, m, &s);
                    cube = dem_body_add(w, m, scene_box(w, edge, edge, edge), at(2e-4, 1e-4, 0.016), straight);
                    CHECK_EQ(dem_world_run(w, 0.25, 0, 0), DEM_OK);
                    z = (double)scene_state(w, cube).position.z;
                    if (large) CHECK_NEAR(z, top_of(sort, b) + edge/2, impulses ? 2e-6 : 2e-4);
                    else CHECK(z < -0.05);
                    if (large) CHECK((double)demi_length(scene_state(w, cube).velocity) < (impulses ? 1e-6 : 1e-3));
                    dem_world_destroy(w);
                }
    }

    TEST("sieve rocks: under impulses a block slides over bars, holes and weave at g (sin - mu cos) without catching") {
        int sort;
        for (sort = 0; sort < SORTS; sort++) {
            dem_sieve_desc s = sieve_of(sort, 0.006, 0.004);
            const double edge = 0.03, angle = 0.7;
            dem_material m;
            const double dt = sort < SQUARE ? 1e-4 : 1e-3;      /* a round wire is a plane for a step */
            dem_world *w = world_of(1, 0, 0, 0, 0.5, dt, &m);
            dem_body block;
            dem_wall_sieve_add(w, m, &s);
            block = dem_body_add(w, m, scene_box(w, edge, edge, edge/2), at(3e-4, 2e-4, top_of(sort, 0.004) + edge/4), straight);
            dem_world_gravity_set(w, at(earth*sin(angle), 0, -earth*cos(angle)));
            CHECK_EQ(dem_world_run(w, 0.2, 0, 0), DEM_OK);
            CHECK_REL((double)scene_state(w, block).velocity.x, 0.2*earth*(sin(angle) - 0.5*cos(angle)), fine ? 2e-3 : 2e-2);
            CHECK_NEAR((double)scene_state(w, block).velocity.y, 0, 1e-3);
            dem_world_destroy(w);
        }
    }

    TEST("sieve rocks: a steep wedge that falls into a hole jams and counts as blinded") {
        int impulses, sort;
        for (impulses = 0; impulses < 2; impulses++)
            for (sort = SQUARE; sort < SORTS; sort++) {
                const double a = 0.01;
                const dem_real p[15] = {0, 0, DEM_R(-0.03), DEM_R(0.007), DEM_R(0.007), DEM_R(0.015), DEM_R(-0.007), DEM_R(0.007),
                                        DEM_R(0.015), DEM_R(0.007), DEM_R(-0.007), DEM_R(0.015), DEM_R(-0.007), DEM_R(-0.007),
                                        DEM_R(0.015)};
                dem_sieve_desc s = sieve_of(sort, a, 0.004);
                dem_material m;
                dem_world *w = world_of(impulses, earth, 1e7, 0.2, 0.5, impulses ? 1e-3 : 2e-5, &m);
                dem_body wedge;
                dem_wall sieve = dem_wall_sieve_add(w, m, &s);
                wedge = dem_body_add(w, m, dem_shape_polyhedron_add(w, 5, p), at(0, 0, 0.02), straight);
                CHECK_EQ(dem_sieve_blinded_get(w, sieve, 0) > 0, 0);
                CHECK_EQ(dem_world_run(w, 0.3, 0, 0), DEM_OK);
                CHECK_EQ(dem_sieve_blinded_get(w, sieve, DEM_R(0.01)), 1);
                CHECK(scene_state(w, wedge).position.z > DEM_R(-0.02));
                dem_world_destroy(w);
            }
    }

    TEST("sieve rocks: a square prism jammed in a round hole or tube keeps a friction spring per edge: a twist "
         "springs back") {
        int tube;
        for (tube = 0; tube < 2; tube++) {
            const double half = 0.005*sqrt(0.5)*1.01;
            dem_sieve_desc s = sieve_of(ROUND, 0.01, 0.004);
            dem_material m;
            dem_world *w = world_of(0, 0, 1e7, 0.3, 0.5, fine ? 5e-6 : 1e-5, &m);
            dem_body prism;
            double most = 0, twist = 0;
            int i;
            s.thickness = DEM_R(0.01);
            if (tube) dem_wall_cylinder_add(w, m, at(0, 0, 0), at(0, 0, 1), DEM_R(0.005), 1);
            else dem_wall_sieve_add(w, m, &s);
            prism = dem_body_add(w, m, scene_box(w, 2*half, 2*half, 0.008), at(0, 0, 0), straight);
            scene_move(w, prism, at(0, 0, 0), at(0, 0, 0.3));
            for (i = 0; i < 400; i++) {
                CHECK_EQ(scene_step(w, 10), DEM_OK);
                twist = 2*(double)scene_state(w, prism).orientation.z;
                most = fmax(most, fabs(twist));
            }
            CHECK(most > 1e-5);
            CHECK(fabs(twist) < 0.9*most);
            if (getenv("SIEVE_NUMBERS")) printf("twist: %g of %g rad\n", twist, most);
            dem_world_destroy(w);
        }
    }

    TEST("sieve rocks: reduced holes and sieves cut from a disc are rejected, unions with an ellipsoid and sheets accepted") {
        static const char *const says[2] = {"reduced holes are only for spheres", "cut from a disc"};
        int k, order, egg;
        for (k = 0; k < 4; k++)
            for (egg = 0; egg < 4; egg++)       /* a box, an ellipsoid, a union of both in either order */
                for (order = 0; order < 2; order++) {
                    dem_sieve_desc s = sieve_of(SQUARE, 0.01, 0.004);
                    dem_material m;
                    dem_world *w = world_of(k == 3, 0, 1e7, 0.5, 0, 1e-5, &m);
                    const dem_real x[6] = {0, 0, 0, DEM_R(0.01), 0, 0};
                    dem_shape two[2], shape;
                    int done = 0, turn;
                    two[egg == 3] = scene_box(w, 0.02, 0.02, 0.02);
                    two[egg != 3] = dem_shape_ellipsoid_add(w, at(0.01, 0.02, 0.01));
                    shape = egg < 2 ? two[egg] : dem_shape_union_add(w, 2, two, x, 0);
                    CHECK(shape.id);
                    if (k == 0) { s.kind = DEM_SIEVE_REDUCED; s.thickness = 0; }
                    if (k == 1) s.radius = DEM_R(0.1);
                    if (k >= 2) s.thickness = 0;
                    for (turn = 0; turn < 2; turn++)
                        done = order == turn ? dem_wall_sieve_add(w, m, &s).id > 0
                            : dem_body_add(w, m, shape, at(0, 0, 0.03), straight).slot > 0;
                    CHECK_EQ(done, k >= 2);
                    if (k < 2) CHECK_STR(dem_world_error_get(w), says[k]);
                    if (k < 2) CHECK_STR(dem_world_error_get(w), "nothing was added");
                    CHECK_EQ(scene_step(w, 2), DEM_OK);
                    dem_world_destroy(w);
                }
    }
    return test_end();
}
