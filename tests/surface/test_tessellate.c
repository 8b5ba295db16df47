/* Curved walls and sieves as facets, for bodies without a closed form: ellipsoids on sieves and cones, polyhedra in
   drums and on sheets. They act as spheres' closed forms do, conserve energy, and last through checkpoints. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const int fine = sizeof(dem_real) == 8;
static const dem_quat straight = {1, 0, 0, 0};
enum { WEAVE, BARS, SQUARE, SLOTS, ENDLESS, ROUND, STAGGERED, SHEET, HOLES, FUNNEL, BOWL, TUBE, SORTS };
enum { BALL, ROUND_EGG, EGG, ROCK, CUBE };
static dem_wall wall_of(dem_world *w, dem_material m, int sort, int turned) {
    static const dem_sieve_kind kinds[] = {DEM_SIEVE_WIRES, DEM_SIEVE_BARS, DEM_SIEVE_SQUARE, DEM_SIEVE_SLOTS, DEM_SIEVE_SLOTS,
                                           DEM_SIEVE_ROUND, DEM_SIEVE_ROUND, DEM_SIEVE_SQUARE, DEM_SIEVE_ROUND};
    const dem_real bowl_r[4] = {0, DEM_R(0.02), DEM_R(0.035), DEM_R(0.04)}, bowl_h[4] = {0, DEM_R(0.004), DEM_R(0.02), DEM_R(0.06)};
    dem_sieve_desc s = DEM_SIEVE_DESC;
    if (sort == FUNNEL) return dem_wall_cone_add(w, m, at(0, 0, -0.01), at(0, 0, 0.03), DEM_R(0.004), DEM_R(0.04));
    if (sort == BOWL) return dem_wall_revolved_add(w, m, at(0, 0, -0.01), at(0, 0, 1), 4, bowl_r, bowl_h);
    if (sort == TUBE) return dem_wall_cylinder_add(w, m, at(0, 0, 0.03), at(1, 0.2, 0), DEM_R(0.03), 1);
    s.kind = kinds[sort];
    s.aperture = DEM_R(0.012);
    s.bar = DEM_R(0.005);
    if (sort >= SQUARE && sort < SHEET) s.thickness = s.bar;
    if (sort == WEAVE) s.lift = DEM_R(0.008);    /* apart: facets do not know where wires cross */
    if (sort == SLOTS) s.length = DEM_R(0.03);
    if (sort == STAGGERED) s.staggered = 1;
    if (turned) {
        s.point = at(0.003, 0.001, 0);
        s.along = at(1, 0.3, 0);
    }
    return dem_wall_sieve_add(w, m, &s);
}
static dem_world *world_of(int impulses, double restitution, double friction, double dt, dem_material *m) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *w;
    desc.gravity = at(0, 0, -9.81);
    desc.response = impulses ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS;
    desc.dt = (dem_real)dt;
    desc.allow_large_dt = !impulses;
    desc.ledger = 1;
    desc.threads = 1;
    w = dem_world_create(&desc);
    *m = scene_material(w, impulses ? 0 : 2e7, restitution, friction, 0);
    return w;
}
static dem_body put(dem_world *w, dem_material m, int kind, double r, dem_vec3 x, dem_quat q) {
    uint64_t random = 5;
    if (kind == BALL) return dem_sphere_add(w, m, (dem_real)r, x);
    return dem_body_add(w, m, kind == ROUND_EGG ? dem_shape_ellipsoid_add(w, at(r, r, r))
                        : kind == EGG ? dem_shape_ellipsoid_add(w, at(r, 0.6*r, 0.8*r))
                        : kind == ROCK ? scene_rock(w, &random, 20, r) : scene_box(w, 1.2*r, r, 1.1*r), x, q);
}
static void box_around(dem_world *w, dem_material m) {
    int i;
    dem_wall_plane_add(w, m, at(0, 0, -0.05), at(0, 0, 1));
    dem_wall_plane_add(w, m, at(0, 0, 0.08), at(0, 0, -1));
    for (i = 0; i < 4; i++) {
        const double side = i & 1 ? 0.045 : -0.045, n = i & 1 ? -1 : 1;
        dem_wall_plane_add(w, m, i < 2 ? at(side, 0, 0) : at(0, side, 0), i < 2 ? at(n, 0, 0) : at(0, n, 0));
    }
}
static double energy(const dem_world *w) {
    const dem_ledger l = dem_ledger_get(w);
    const dem_totals t = dem_totals_get(w);
    return l.kinetic + l.rotational + l.elastic + 9.81*t.mass*t.centre[2];
}
/* How many contacts there are with a wall. */
static int touches(const dem_world *w, int wall) {
    static dem_contact_info c[400];
    const int n = dem_contacts_get(w, c, 400);
    int i, count = 0;
    for (i = 0; i < n && i < 400; i++) count += c[i].wall == wall;
    return count;
}
/* Grains of two sizes on a shaken wall, as steps go on a third, smaller size. */
static dem_world *shaken(int sort, int impulses, int steps) {
    dem_material m;
    dem_world *w = world_of(impulses, 0.4, 0.5, impulses ? 5e-4 : 2e-5, &m);
    dem_motion shake = DEM_MOTION;
    dem_wall wall = wall_of(w, m, sort, 1);
    const dem_shape small = dem_shape_ellipsoid_add(w, at(0.0015, 0.001, 0.0012));
    uint64_t random = 3;
    int i;
    shake.kind = DEM_MOTION_OSCILLATING;
    shake.velocity = at(0, 0, 1);
    shake.amplitude = DEM_R(0.002);
    shake.frequency = 25;
    CHECK_EQ(dem_wall_motion_set(w, wall, &shake), DEM_OK);
    box_around(w, m);
    for (i = 0; i < 24; i++)
        put(w, m, i%3 == 2 && (impulses || sort >= SHEET) ? ROCK : EGG, i%2 ? 0.006 : 0.0035,
            at(-0.018 + 0.012*(i%4), -0.018 + 0.012*(i/4%4), 0.02 + 0.014*(i/16)), scene_turn(&random));
    for (i = 0; i < steps && i < 2; i++) {
        CHECK_EQ(scene_step(w, i ? steps - steps/2 : steps/2), DEM_OK);
        if (!i) dem_body_add(w, m, small, at(0.001, 0.002, 0.06), straight);
    }
    return w;
}
/* A round bar of 0.4 mm along y at x = 0.9 mm: of a sieve, or a mesh with a ring of corners at y = 0, 3.6 and 7.2 mm. */
static void bar_along_y(dem_world *w, dem_material m, int mesh) {
    enum { N = 12 };
    dem_sieve_desc bars = DEM_SIEVE_DESC;
    dem_mesh d;
    dem_real v[9*N];
    int32_t t[12*N];
    int i;
    bars.kind = DEM_SIEVE_BARS;
    bars.aperture = DEM_R(0.0014);
    bars.bar = DEM_R(0.0004);
    if (!mesh) { CHECK(dem_wall_sieve_add(w, m, &bars).id); return; }
    for (i = 0; i < 3*N; i++) {
        const dem_vec3 x = at(0.0009 + 0.0002*cos(2*DEMI_PI*(i%N)/N), 0.0036*(i/N), 0.0002*sin(2*DEMI_PI*(i%N)/N));
        const int32_t next = i/N*N + (i + 1)%N, four[6] = {i, next, next + N, i, next + N, i + N};
        v[3*i] = x.x; v[3*i + 1] = x.y; v[3*i + 2] = x.z;
        if (i < 2*N) memcpy(t + 6*i, four, sizeof four);
    }
    d.vertex_count = 3*N; d.triangle_count = 4*N; d.vertices = v; d.triangles = t;
    CHECK(dem_wall_mesh_add(w, m, &d).id);
}
/* Hertz's law, called in gaps, too. */
static void reaching(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    if (c->overlap > 0) dem_law_hertz(c, memory, f);
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("tessellate: an ellipsoid of equal axes bounces on sieves, cones and bowls as a sphere does, by springs and "
         "impulses") {
        int sort, impulses, k;
        for (sort = 0; sort < TUBE; sort++)
            for (impulses = 0; impulses < 2; impulses++)
                for (k = 0; k < 4; k++) {
                    static const double from[4][2] = {{0.002, 0.0015}, {0.0055, 0.0005}, {-0.0005, -0.006}, {0.0035, -0.001}};
                    dem_body_state s[2];
                    int i;
                    for (i = 0; i < 2; i++) {
                        dem_material m;
                        dem_world *w = world_of(impulses, 0.5, 0, impulses ? 1e-4 : 1e-5, &m);
                        dem_body b;
                        CHECK(wall_of(w, m, sort, 0).id);
                        b = put(w, m, i ? ROUND_EGG : BALL, 0.007, at(from[k][0], from[k][1], sort == BOWL ? 0.004 : 0.012), straight);
                        scene_move(w, b, at(0, 0, -0.5), at(0, 0, 0));
                        CHECK_EQ(dem_world_run(w, 0.02, 0, 0), DEM_OK);
                        s[i] = scene_state(w, b);
                        dem_world_destroy(w);
                    }
                    /* chords of up to 5e-4 of the power of two below its radius turn normals by up to 0.02 */
                    CHECK((double)demi_size(demi_sub(s[1].position, s[0].position)) < 4e-2*0.007);
                    CHECK((double)demi_size(demi_sub(s[1].velocity, s[0].velocity)) < 4e-2);
                    if (getenv("TESSELLATE_NUMBERS"))
                        printf("sort %d impulses %d from %d: %.1e R, %.1e m/s\n", sort, impulses, k,
                               (double)demi_size(demi_sub(s[1].position, s[0].position))/0.007,
                               (double)demi_size(demi_sub(s[1].velocity, s[0].velocity)));
                }
    }

    TEST("tessellate: elastic ellipsoids on every sieve, cone and bowl, and polyhedra in tubes, cones and on sheets, "
         "conserve energy") {
        int sort;
        for (sort = 0; sort < SORTS; sort++) {
            dem_material m;
            dem_world *w = world_of(0, 1, 0, fine ? 1e-5 : 2e-5, &m);
            uint64_t random = 7;
            double before, worst = 0;
            int i, result = DEM_OK, touched = 0;
            CHECK(wall_of(w, m, sort, 1).id);
            if (sort != TUBE) box_around(w, m);
            for (i = 0; i < 8; i++) {
                const dem_body b = put(w, m, sort == TUBE || (sort >= SHEET && i%2) ? i%2 ? ROCK : CUBE : EGG,
                                       i%2 ? 0.0065 : 0.0045, at(-0.012 + 0.015*(i%2), -0.01 + 0.016*(i/2%2), i/4 ? 0.025 : 0.041),
                                       scene_turn(&random));
                scene_move(w, b, scene_at(&random, 2, -1, 2, -1, 2, -1), scene_at(&random, 80, -40, 80, -40, 80, -40));
            }
            before = energy(w);
            for (i = 0; i < 100 && result == DEM_OK; i++) {
                result = scene_step(w, fine ? 80 : 40);
                worst = fmax(worst, fabs(energy(w) - before)/before);
                touched += touches(w, 1);
            }
            CHECK_EQ(result, DEM_OK);
            CHECK(worst < (fine ? 1e-4 : 2e-2));
            CHECK(touched > 2);
            if (getenv("TESSELLATE_NUMBERS")) printf("sort %d: %g, %d\n", sort, worst, touched);
            dem_world_destroy(w);
        }
    }

    TEST("tessellate: an ellipsoid thinner than a hole falls through, a thicker one rests, by springs and impulses") {
        int sort, impulses, large;
        for (sort = 0; sort < FUNNEL; sort++)
            for (impulses = 0; impulses < 2; impulses++)
                for (large = 0; large < 2; large++) {
                    dem_material m;
                    dem_world *w = world_of(impulses, 0.2, 0.3, impulses ? 5e-4 : 2e-5, &m);
                    dem_body b;
                    double z;
                    wall_of(w, m, sort, 0);
                    b = put(w, m, EGG, large ? 0.014 : 0.005, at(2e-4, 1e-4, 0.02), straight);
                    CHECK_EQ(dem_world_run(w, 0.3, 0, 0), DEM_OK);
                    z = (double)scene_state(w, b).position.z;
                    if (large) CHECK(z > 0 && z < 0.02);
                    else CHECK(z < -0.05);
                    dem_world_destroy(w);
                }
    }

    TEST("tessellate: a cube rests on a sheet with holes by springs, and slides over them as over a thick plate") {
        double x[2], v[2];
        int sort, i;
        for (sort = SHEET; sort <= HOLES; sort++)
            for (i = 0; i < 2 - (sort == HOLES); i++) {
                const double up = i ? 0.0025 : 0;       /* m, half the thickness */
                dem_material m;
                dem_world *w = world_of(0, 0.2, 0.2, 1e-5, &m);
                dem_body b;
                wall_of(w, m, i ? SQUARE : sort, 0);
                b = dem_body_add(w, m, scene_box(w, 0.03, 0.03, 0.01), at(0.001, 0.002, 0.005 + up), straight);
                CHECK_EQ(dem_world_run(w, sort == HOLES ? 0.02 : 0.1, 0, 0), DEM_OK);
                CHECK_NEAR((double)scene_state(w, b).position.z, 0.005 + up, 3e-5);
                CHECK((double)demi_length(scene_state(w, b).velocity) < (sort == HOLES ? 1e-2 : 1e-3));
                scene_move(w, b, at(0.5, 0, 0), at(0, 0, 0));
                if (sort == SHEET) CHECK_EQ(dem_world_run(w, 0.02, 0, 0), DEM_OK);
                x[i] = (double)scene_state(w, b).position.x;
                v[i] = (double)scene_state(w, b).velocity.x;
                dem_world_destroy(w);
                if (!i) continue;
                CHECK_REL(x[0], x[1], fine ? 1e-6 : 1e-2);
                CHECK_REL(v[0], v[1], fine ? 1e-6 : 1e-2);
                CHECK(v[0] < 0.47 && v[0] > 0.44);
            }
    }

    TEST("tessellate: a shaken sieve or funnel with grains of three sizes restarts bit for bit") {
        int sort, impulses, contacts = 0;
        for (sort = 0; sort < TUBE; sort++)
            for (impulses = 0; impulses < 2; impulses++) {
                const int steps = impulses ? 160 : 3000;
                dem_world *v = shaken(sort, impulses, steps), *t;
                contacts += dem_contacts_get(v, 0, 0);
                CHECK_EQ(dem_checkpoint_write(v, "build/tmp/tessellate.dem"), DEM_OK);
                t = shaken(sort, impulses, 0);
                CHECK_EQ(dem_checkpoint_read(t, "build/tmp/tessellate.dem"), DEM_OK);
                CHECK_EQ(scene_step(v, steps/2), DEM_OK);
                CHECK_EQ(scene_step(t, steps/2), DEM_OK);
                CHECK_EQ(dem_world_hash_get(t), dem_world_hash_get(v));
                dem_world_destroy(v);
                dem_world_destroy(t);
            }
        CHECK(contacts > 100);
    }

    TEST("tessellate: on a rotating drum, cylinder or endless sieve eggs, cubes and squares move as with a list "
         "rebuilt every step, and gain no energy") {
        enum { EGG_ON_SIEVE, EGG_IN_DRUM, CUBE_IN_DRUM, CUBE_IN_TUBE, SQUARE_IN_TUBE, CASES };
        int k, impulses, way;
        for (k = 0; k < CASES; k++)
            for (impulses = 0; impulses < (k == EGG_IN_DRUM ? 2 : 1); impulses++) {
                dem_body_state s[2];
                dem_ledger l;
                for (way = 0; way < 2; way++) {
                    const int planar = k == SQUARE_IN_TUBE;
                    const dem_real r[2] = {DEM_R(0.05), DEM_R(0.05)}, h[2] = {DEM_R(-0.05), DEM_R(0.05)};
                    dem_real square[8] = {DEM_R(-0.004), DEM_R(-0.004), DEM_R(0.004), DEM_R(-0.004), DEM_R(0.004),
                                          DEM_R(0.004), DEM_R(-0.004), DEM_R(0.004)};
                    dem_world_desc desc = DEM_WORLD_DESC;
                    dem_motion turn = DEM_MOTION;
                    dem_sieve_desc sieve = DEM_SIEVE_DESC;
                    dem_material m;
                    dem_shape shape;
                    dem_world *w;
                    dem_wall wall;
                    dem_body b;
                    /* a wall of revolution that rotates about its axis stays where it is, but its facets turn */
                    desc.planar = planar;
                    desc.ledger = 1;
                    desc.gravity = k == EGG_ON_SIEVE ? at(0, 0, -9.81) : at(0, -9.81, 0);
                    if (way) desc.skin = -1;
                    if (impulses) { desc.response = DEM_RESPONSE_IMPULSES; desc.dt = DEM_R(2e-4); }
                    w = dem_world_create(&desc);
                    m = scene_material(w, 1e7, 0.5, 0, 0);
                    shape = planar ? dem_shape_polygon_add(w, 4, square) : k == CUBE_IN_DRUM || k == CUBE_IN_TUBE
                        ? scene_box(w, 0.01, 0.01, 0.01) : dem_shape_ellipsoid_add(w, at(0.006, 0.004, 0.005));
                    sieve.kind = DEM_SIEVE_SQUARE;
                    sieve.aperture = DEM_R(0.003);
                    sieve.bar = DEM_R(0.004);
                    wall = k == EGG_ON_SIEVE ? dem_wall_sieve_add(w, m, &sieve)
                        : k == CUBE_IN_TUBE || planar
                        ? dem_wall_cylinder_add(w, m, at(0, 0, 0), at(0, 0, 1), DEM_R(0.05), 1)
                        : dem_wall_revolved_add(w, m, at(0, 0, 0), at(0, 0, 1), 2, r, h);
                    turn.kind = DEM_MOTION_ROTATING;
                    turn.axis = at(0, 0, 1);
                    turn.speed = 12;
                    CHECK_EQ(dem_wall_motion_set(w, wall, &turn), DEM_OK);
                    b = dem_body_add(w, m, shape, k == EGG_ON_SIEVE ? at(0.04, 0, 0.0051) : at(0, k == CUBE_IN_DRUM ||
                        k == CUBE_IN_TUBE ? -0.0447 : -0.0457, 0), straight);
                    CHECK(b.slot);
                    CHECK_EQ(dem_world_run(w, 0.06, 0, 0), DEM_OK);
                    s[way] = scene_state(w, b);
                    l = dem_ledger_get(w);
                    if (!impulses) CHECK(fabs(l.residual) < (fine ? 1e-4 : 1e-2)*l.throughput);
                    dem_world_destroy(w);
                }
                /* without friction it rocks where it lies */
                CHECK((double)demi_length(s[0].velocity) < 0.06);
                CHECK_NEAR(s[0].position.x, s[1].position.x, fine ? 1e-8 : 1e-4);
                CHECK_NEAR(s[0].position.y, s[1].position.y, fine ? 1e-8 : 1e-4);
                CHECK_NEAR(s[0].position.z, s[1].position.z, fine ? 1e-8 : 1e-4);
            }
    }

    TEST("tessellate: an ellipsoid whose law reaches round a bar is pushed alike all along it") {
        double most = 0, worst = 0;                 /* a seam at 7.2 mm; cells end at 6.3 and 8.1 mm */
        int i, k;
        for (k = 0; k < 10; k++) {                  /* the law reaches farther and farther round it */
            dem_vec3 first = at(0, 0, 0);
            for (i = 0; i < 20; i++) {
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_material m;
                dem_world *w;
                dem_body b;
                desc.law = reaching;
                desc.law_stiffness = 1000;
                desc.law_range = (dem_real)(1e-4*(1 + k/2));
                desc.dt = DEM_R(1e-7);
                if (k%2) {
                    desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
                    desc.domain = dem_box_make(-0.01, 0, -0.01, 0.01, 0.0072, 0.01);
                }
                w = dem_world_create(&desc);
                m = scene_material(w, 1e7, 1, 0, 0);
                bar_along_y(w, m, k%2);
                b = dem_body_add(w, m, dem_shape_ellipsoid_add(w, at(0.0008, 0.0004, 0.0003)),
                                 at(0.0011, 0.00623 + 0.0001*i, 0.00055),
                                 dem_quat_make(1, DEM_R(-0.9), DEM_R(-0.8), DEM_R(-0.6)));
                CHECK_EQ(scene_step(w, 1), DEM_OK);
                if (!i) first = scene_state(w, b).velocity;
                worst = fmax(worst, (double)demi_length(demi_sub(scene_state(w, b).velocity, first)));
                most = fmax(most, (double)demi_length(first));
                dem_world_destroy(w);
            }
            if (getenv("TESSELLATE_NUMBERS")) printf("reach %d: %g of %g m/s\n", k, worst, most);
            CHECK(most > 0);
            CHECK(worst < (fine ? 1e-9 : 1e-3)*most);
            worst = most = 0;
        }
    }
    return test_end();
}
