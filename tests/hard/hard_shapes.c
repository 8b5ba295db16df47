/* Hard cases of shapes: needles and discs of 100 and 1000 to 1, nearly parallel, deep and shallow,
   aligned, crossed and concentric; clusters that are a point, a line, a hook. Each test names where
   its case or its number comes from. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"
#include <stdlib.h>

typedef long double wide;
static const double pi = 3.14159265358979323846;
static const int single = sizeof(dem_real) == sizeof(float);

static dem_quat upright(void) { return dem_quat_make(1, 0, 0, 0); }
static dem_quat random_turn(uint64_t *seed) {
    const dem_vec3 axis = scene_at(seed, 2, -1, 2, -1, 2, -1);
    return dem_quat_about(axis, (dem_real)(2*pi*scene_random(seed)));
}
static dem_ellipsoid egg(double x, double y, double z, double a, double b, double c, dem_quat q) {
    dem_ellipsoid e;
    e.position = at(x, y, z);
    e.semi_axes = at(a, b, c);
    e.orientation = q;
    return e;
}

/* ---- a proof that two scaled ellipsoids touch ---- */

/* The rotation of a quaternion of any length. */
static void wide_matrix(dem_quat q, wide R[9]) {
    const wide w = q.w, x = q.x, y = q.y, z = q.z, s = 2/(w*w + x*x + y*y + z*z);
    R[0] = 1 - s*(y*y + z*z); R[1] = s*(x*y - w*z); R[2] = s*(x*z + w*y);
    R[3] = s*(x*y + w*z); R[4] = 1 - s*(x*x + z*z); R[5] = s*(y*z - w*x);
    R[6] = s*(x*z - w*y); R[7] = s*(y*z + w*x); R[8] = 1 - s*(x*x + y*y);
}
/* A = R diag(a^2) R^T. */
static void wide_form(const dem_ellipsoid *e, wide A[9]) {
    const wide s[3] = {e->semi_axes.x, e->semi_axes.y, e->semi_axes.z};
    wide R[9];
    int i, j, k;
    wide_matrix(e->orientation, R);
    for (i = 0; i < 3; i++)
        for (j = 0; j < 3; j++) {
            A[3*i + j] = 0;
            for (k = 0; k < 3; k++) A[3*i + j] += R[3*i + k]*s[k]*s[k]*R[3*j + k];
        }
}
/* M x = r by Gauss with pivots, of three. */
static void wide_solve(const wide M[9], const wide r[3], wide x[3]) {
    wide m[3][4];
    int i, j, k;
    for (i = 0; i < 3; i++) {
        for (j = 0; j < 3; j++) m[i][j] = M[3*i + j];
        m[i][3] = r[i];
    }
    for (k = 0; k < 3; k++) {
        int best = k;
        for (i = k + 1; i < 3; i++) if (fabsl(m[i][k]) > fabsl(m[best][k])) best = i;
        for (j = 0; j < 4; j++) { const wide t = m[k][j]; m[k][j] = m[best][j]; m[best][j] = t; }
        for (i = k + 1; i < 3; i++) {
            const wide t = m[i][k]/m[k][k];
            for (j = k; j < 4; j++) m[i][j] -= t*m[k][j];
        }
    }
    for (i = 2; i >= 0; i--) {
        x[i] = m[i][3];
        for (j = i + 1; j < 3; j++) x[i] -= m[i][j]*x[j];
        x[i] /= m[i][i];
    }
}
/* [PW85]'s function l (1 - l) r^T ((1 - l) A + l B)^-1 r, which is concave. */
static wide pw_value(const wide A[9], const wide B[9], const wide r[3], wide l) {
    wide M[9], x[3];
    int i;
    for (i = 0; i < 9; i++) M[i] = (1 - l)*A[i] + l*B[i];
    wide_solve(M, r, x);
    return l*(1 - l)*(r[0]*x[0] + r[1]*x[1] + r[2]*x[2]);
}
/* W0 by brute force: 1000 places, thicker towards the ends, then thirds about the best of them. */
static wide scale_searched(const dem_ellipsoid *a, const dem_ellipsoid *b) {
    enum { PLACES = 1000 };
    wide A[9], B[9], r[3], lo, hi, most = 0;
    int i, best = 1;
    wide_form(a, A);
    wide_form(b, B);
    r[0] = (wide)b->position.x - (wide)a->position.x;
    r[1] = (wide)b->position.y - (wide)a->position.y;
    r[2] = (wide)b->position.z - (wide)a->position.z;
    for (i = 1; i < PLACES; i++) {
        const wide f = pw_value(A, B, r, (1 - cosl((wide)pi*i/PLACES))/2);
        if (f > most) { most = f; best = i; }
    }
    lo = (1 - cosl((wide)pi*(best - 1)/PLACES))/2;
    hi = (1 - cosl((wide)pi*(best + 1)/PLACES))/2;
    for (i = 0; i < 120; i++) {
        const wide s = lo + (hi - lo)/3, t = hi - (hi - lo)/3;
        if (pw_value(A, B, r, s) < pw_value(A, B, r, t)) lo = s;
        else hi = t;
    }
    return sqrtl(pw_value(A, B, r, (lo + hi)/2));
}
typedef struct worst { double scale, swap, normal; int iterations; } worst;
/* Against brute force, and with a and b exchanged. */
static void meet(const dem_ellipsoid *a, const dem_ellipsoid *b, worst *w) {
    const dem_ellipsoid_contact m = dem_ellipsoids_contact_get(a, b, 0);
    const dem_ellipsoid_contact n = dem_ellipsoids_contact_get(b, a, 0);
    const dem_vec3 sum = demi_add(m.normal, n.normal);
    const double should = (double)scale_searched(a, b);
    CHECK(demi_finite(m.scale) && demi_finite3(m.point) && demi_finite3(m.normal));
    CHECK(demi_finite(m.depth_normal) && demi_finite(m.depth_chord));
    CHECK_NEAR(demi_length(m.normal), 1, single ? 1e-6 : 1e-14);
    w->scale = fmax(w->scale, fabs((double)m.scale - should)/fmax(should, 1e-3));
    w->swap = fmax(w->swap, fabs((double)(m.scale - n.scale))/fmax(should, 1e-3));
    w->normal = fmax(w->normal, (double)demi_length(sum));
    if (m.iterations > w->iterations) w->iterations = m.iterations;
    if (n.iterations > w->iterations) w->iterations = n.iterations;
}
/* Axes of a needle (way 0), a disc (1), or one with three different (2), in some order. */
static dem_vec3 axes_of(int way, double aspect, int turned) {
    const double s[3] = {way == 1 ? aspect : 1, way == 2 ? sqrt(aspect) : way == 1 ? aspect : 1,
                         way == 1 ? 1 : aspect};
    return at(s[turned%3], s[(turned + 1)%3], s[(turned + 2)%3]);
}

/* K^-1 comes from cofactors, whose products are aspect^4 times as large as the smallest of them:
   that many units of round-off, on 0.09 of r^T K^-1 r at 0.3 of the long axis. Quaternions of
   single precision turn by 1e-7, which moves a needle's side by aspect times that. */
static double meet_bound(double aspect) {
    return 2.2e-16*(0.1*pow(aspect, 4) + 30) + (single ? 3e-7*aspect : 0);
}
static void meet_check(const worst *w, double aspect) {
    CHECK_NEAR(w->scale, 0, meet_bound(aspect));
    CHECK_NEAR(w->swap, 0, meet_bound(aspect));
    CHECK_NEAR(w->normal, 0, single ? 1e-6 : 1e-8);
    CHECK(w->iterations <= 40);                 /* 100 is where the search gives up */
}
static void meet_random(double aspect, uint64_t *seed) {
    static const double scales[6] = {0.01, 0.3, 0.9, 0.999999, 1.000001, 3};
    worst w = {0, 0, 0, 0};
    int i;
    for (i = 0; i < 36; i++) {
        dem_ellipsoid a = egg(0, 0, 0, 1, 1, 1, random_turn(seed)), b;
        const dem_vec3 way = scene_at(seed, 2, -1, 2, -1, 2, -1);
        b = a;
        b.orientation = random_turn(seed);
        a.semi_axes = axes_of(i%3, aspect, i);
        b.semi_axes = axes_of(i/3%3, aspect, i/2);
        b.position = way;
        b.position = demi_scale(way, (dem_real)(scales[i%6]/(double)scale_searched(&a, &b)));
        meet(&a, &b, &w);
    }
    meet_check(&w, aspect);
}
/* Equal ones, turned against each other by next to nothing, side on side; in the middle or 0.3 of
   their length along. */
static void meet_parallel(int way, double aspect, uint64_t *seed) {
    static const double tilts[6] = {0, 1e-12, 1e-9, 1e-6, 1e-4, 1e-2}, gaps[3] = {-1e-6, 0, 1e-6};
    const dem_vec3 s = axes_of(way, aspect, 0);
    worst w = {0, 0, 0, 0};
    int i, j;
    for (i = 0; i < 6; i++)
        for (j = 0; j < 6; j++) {
            const double gap = gaps[j%3], off = j/3 ? 0.3 : 0;
            const dem_quat q = random_turn(seed), t = dem_quat_about(at(1, j, 0),
                                                                     (dem_real)tilts[i]);
            const dem_vec3 r = dem_quat_rotate(q, way == 1
                ? at(off*(double)s.x, 0, 2*(double)s.z*(1 + gap))
                : at(2*(double)s.x*(1 + gap), 0, off*(double)s.z));
            dem_ellipsoid a = egg(0, 0, 0, 1, 1, 1, q), b = a;
            b.position = r;
            b.orientation = dem_quat_multiply(q, t);
            a.semi_axes = b.semi_axes = s;
            meet(&a, &b, &w);
        }
    meet_check(&w, aspect);
}

/* ---- worlds of hard shapes ---- */

static dem_world_desc shapes_desc(double dt) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.threads = 1;
    desc.ledger = 1;
    desc.dt = (dem_real)dt;
    desc.normal_law = DEM_NORMAL_LINEAR;
    return desc;
}
static dem_material spring_stuff(dem_world *world, double k, double restitution, double friction) {
    dem_material_desc m = scene_stuff(1e7, restitution, friction, 0);
    m.stiffness = (dem_real)k;
    return dem_material_add(world, &m);
}
static double mass_of(double a, double b, double c) { return 2500*4*pi/3*a*b*c; }
static void launch(dem_world *world, dem_body body, dem_vec3 velocity, dem_vec3 spin) {
    scene_move(world, body, velocity, spin);
}
typedef struct outcome { double energy, momentum, angular, overlap, rate; } outcome;
static double stored(const dem_world *world) {
    const dem_ledger l = dem_ledger_get(world);
    return l.kinetic + l.rotational + l.elastic;
}
/* Two bodies at 2 m/s against each other, turning, `before` steps before they are `from` apart,
   where they would touch; elastic, until they have met and parted. What is lost or gained of energy,
   momentum and angular momentum, of their size. */
static outcome collide(dem_vec3 s, dem_quat qa, dem_quat qb, dem_vec3 from, dem_vec3 spin,
                       double share, double before) {
    const double size = (double)demi_length(from);
    dem_world_desc desc = shapes_desc(1);
    dem_world *world = 0;
    dem_totals t, u;
    dem_advice advice;
    outcome o = {0, 0, 0, 0, 0};
    dem_body a = {0, 0}, b = {0, 0};
    double first, lever;
    const int most = 400000;                    /* tip on tip a contact is long and soft */
    int k, met = 0, blocks;
    for (k = 0; k < 2; k++) {                   /* the second with its share of what is advised */
        dem_material m;
        dem_shape shape;
        dem_world_destroy(world);
        world = dem_world_create(&desc);
        m = spring_stuff(world, 1e7, 1, 0);
        shape = dem_shape_ellipsoid_add(world, s);
        a = dem_body_add(world, m, shape, at(0, 0, 0), qa);
        b = dem_body_add(world, m, shape, k ? demi_scale(from,
            (dem_real)(1 + before*4*(double)desc.dt/size)) : from, qb);
        CHECK_EQ(dem_step_advice_get(world, &advice), DEM_OK);
        desc.dt = (dem_real)(share*(double)advice.dt_max);
        o.rate = pi/20/(double)advice.dt_max;
        if ((double)desc.dt*(double)demi_length(spin) > 0.1)
            desc.dt = (dem_real)(share*0.1/(double)demi_length(spin));
    }
    launch(world, a, demi_scale(from, (dem_real)(1/size)), dem_quat_rotate(qa, spin));
    launch(world, b, demi_scale(from, (dem_real)(-1/size)), dem_quat_rotate(qb, spin));
    scene_step(world, 1);
    first = stored(world);
    t = dem_totals_get(world);
    for (blocks = 0; blocks < most; blocks++) {
        const dem_result result = scene_step(world, 20);
        CHECK_EQ(result, DEM_OK);
        if (result != DEM_OK) break;
        met |= dem_ledger_get(world).elastic > 0;
        if (met && !(dem_ledger_get(world).elastic > 0)) break;
    }
    CHECK(met && blocks < most);
    u = dem_totals_get(world);
    lever = t.mass*size;
    for (k = 0; k < 3; k++) lever = fmax(lever, fabs(t.angular[k]));
    o.energy = stored(world)/first - 1;
    for (k = 0; k < 3; k++) {
        o.momentum = fmax(o.momentum, fabs(u.momentum[k] - t.momentum[k])/t.mass);
        o.angular = fmax(o.angular, fabs(u.angular[k] - t.angular[k])/lever);
    }
    o.overlap = (double)dem_counters_get(world).overlap_max;
    dem_world_destroy(world);
    return o;
}
/* Root mean square of the energy's errors of some collisions, at 0.8 and 0.1 of the largest step. A
   spring of rate w that is met the part s of a step after one, and left the part t, is off by
   (w dt)^2 (s - s^2 - t + t^2): 1/4 (w dt)^2 at most and 0.105 in root mean square, if s and t are
   drawn at random, hence the time before. w dt = pi/20 of that share. Spheres of 1 mm pressed out to
   that aspect; way 2: needles that cross. */
static void collide_some(double aspect, int way, double spin) {
    const int pairs = getenv("TEST_LONG") ? 24 : 8;
    const double thin = 1e-3/pow(aspect, way == 1 ? 2.0/3 : 1.0/3), length = thin*aspect;
    const dem_vec3 s = way == 1 ? at(length, length, thin) : at(thin, thin, length);
    static const double shares[2] = {0.8, 0.1};
    double rms[2] = {0, 0}, coarse = 0;
    uint64_t seed = 5;
    int i, h;
    for (i = 0; i < pairs; i++) {
        const dem_quat cross = dem_quat_about(at(1, 0, 0), (dem_real)(pi/2));
        const dem_quat qa = way == 2 ? upright() : random_turn(&seed);
        const dem_quat qb = way == 2 ? cross : random_turn(&seed);
        dem_vec3 from = way == 2 ? at(1, 0.05*i*thin/length, 0.03*i*thin/length)
                                 : scene_at(&seed, 2, -1, 2, -1, 2, -1);
        const double before = 2 + 2*scene_random(&seed);
        dem_ellipsoid a = egg(0, 0, 0, 1, 1, 1, qa), b = a;
        a.semi_axes = b.semi_axes = s;
        b.position = from;
        b.orientation = qb;
        from = demi_scale(from, (dem_real)(1/(double)scale_searched(&a, &b)));
        for (h = 0; h < 2; h++) {
            const outcome o = collide(s, qa, qb, from, at(spin/5, spin/3, spin), shares[h], before);
            rms[h] += o.energy*o.energy/pairs;
            /* single precision: round-off of a place of this size over v/w, 1 m/s, at random in
               each of the 20/share steps */
            coarse = fmax(coarse, single ? 1.2e-7*length*o.rate*sqrt(20/shares[h]) : 0);
            /* sums of some thousand steps, each off by a unit of round-off */
            CHECK_NEAR(o.momentum, 0, single ? 1e-5 : 1e-13);
            CHECK_NEAR(o.angular, 0, single ? 1e-4 : 1e-10);
            CHECK(o.overlap > 0 && o.overlap < 1);
        }
    }
    for (h = 0; h < 2; h++) {
        const double w_dt = pi/20*shares[h];
        rms[h] = sqrt(rms[h]);
        CHECK_NEAR(rms[h], 0, w_dt*w_dt/8 + coarse);
    }
    if (!single) CHECK(rms[1] < rms[0]/4);      /* 64 in the mean of many */
}

/* What stands under a body that falls: a plane, or a flat mesh whose edge or vertex, or the inside
   of a face, lies under the origin. */
enum { ON_PLANE, ON_FACE, ON_EDGE, ON_VERTEX, GROUNDS };
static void ground_add(dem_world *world, dem_material m, int ground) {
    const double x = ground == ON_FACE ? 0.013 : ground == ON_EDGE ? 0.02 : 0;
    if (ground == ON_PLANE) dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
    else scene_floor(world, m, -0.08 + x, -0.08 + (ground == ON_FACE ? 0.006 : 0), 0.08 + x,
                     0.08 + (ground == ON_FACE ? 0.006 : 0), 4, 4);
}
/* Falls straight at 1 m/s, elastic, onto that ground; how it leaves, and how deep it went. */
static dem_body_state fall(dem_vec3 s, int ground, double dt, double *deep) {
    dem_world_desc desc = shapes_desc(dt);
    dem_world *world;
    dem_material m;
    dem_body_state b;
    dem_body body;
    int k;
    desc.allow_large_dt = 1;                    /* advised is the step for its stiffest place */
    world = dem_world_create(&desc);
    m = spring_stuff(world, 1e6, 1, 0.3);
    ground_add(world, m, ground);
    body = dem_body_add(world, m, dem_shape_ellipsoid_add(world, s),
                        at(0, 0, (double)s.z + 2e-6), upright());
    launch(world, body, at(0, 0, -1), at(0, 0, 0));
    for (k = 0; k < 4000 && !(scene_state(world, body).velocity.z > 0 &&
                              dem_counters_get(world).wall_contacts == 0); k++)
        if (scene_step(world, 10) != DEM_OK) break;
    b = scene_state(world, body);
    *deep = (double)dem_counters_get(world).overlap_max;
    CHECK(*deep > 0 && *deep < 1);
    dem_world_destroy(world);
    return b;
}
/* The overlap is l (1 - z/h), l the radius of equal volume, h the height: F = k (l/h)^2 (h - z), so
   that the body swings with w = l/h sqrt(k/m) and goes v/w deep, v/(w h) of its half width. */
static void falls(dem_vec3 s, int last_ground) {
    const double mass = mass_of((double)s.x, (double)s.y, (double)s.z), h = (double)s.z;
    const double l = cbrt((double)s.x*(double)s.y*(double)s.z), w = l/h*sqrt(1e6/mass);
    double deep[GROUNDS];
    int ground, half;
    for (ground = ON_PLANE; ground <= last_ground; ground++)
        for (half = 0; half < 2; half++) {
            const double steps = half ? 800 : 200, dt = pi/w/steps;
            /* single precision: round-off of the height over v/w, at random in each step */
            const double coarse = single ? 1.2e-7*h*w*sqrt(steps) : 0;
            const dem_body_state b = fall(s, ground, dt, &deep[ground]);
            /* straight up again: nothing turns it, nothing pushes it aside */
            CHECK_NEAR(b.velocity.x, 0, single ? 1e-3 : 1e-9);
            CHECK_NEAR(b.velocity.y, 0, single ? 1e-3 : 1e-9);
            CHECK_NEAR(demi_length(b.spin)*(dem_real)demi_size(s), 0, single ? 1e-2 : 1e-8);
            /* met and left in mid-step: (w dt)^2/8 */
            CHECK_NEAR(b.velocity.z, 1, w*dt*w*dt/8 + coarse);
            CHECK_REL(deep[ground], 1/w/h, w*dt*w*dt/4 + coarse);
        }
}

/* ---- clusters ---- */

static dem_shape cluster_add(dem_world *world, int count, const dem_real *x, double r,
                             dem_cluster_mass mass) {
    dem_cluster_desc d = DEM_CLUSTER_DESC;
    d.count = count;
    d.positions = x;
    d.radius = (dem_real)r;
    d.mass = mass;
    return dem_shape_cluster_add(world, &d);
}
/* A hook of balls of 1 mm in the x-z plane: three quarters of a ring of 4 mm, open to the left (way
   1) or to the right (-1), and a stem from its lower (way 1) or upper end. */
static int hook(dem_real *x, int way) {
    int n = 0, k;
    for (k = 0; k <= 12; k++) {                 /* from -90 to 180 degrees, or turned round */
        const double angle = -pi/2 + k*pi*1.5/12;
        x[3*n] = (dem_real)(way*4e-3*cos(angle));
        x[3*n + 1] = 0;
        x[3*n++ + 2] = (dem_real)(way*4e-3*sin(angle));
    }
    return n;
}
static dem_wall trough_add(dem_world *world, dem_material m, double s) {
    /* three faces that meet at the origin: a corner of a box, open upwards along (1, 1, 1) */
    dem_real v[21];
    static int32_t t[18] = {0, 1, 4, 0, 4, 2, 0, 2, 5, 0, 5, 3, 0, 3, 6, 0, 6, 1};
    static const int corner[7] = {0, 1, 2, 4, 3, 6, 5};    /* bits: x, y, z */
    dem_mesh mesh;
    int i, k;
    for (i = 0; i < 7; i++)
        for (k = 0; k < 3; k++) v[3*i + k] = (dem_real)((corner[i] >> k & 1)*s);
    mesh.vertex_count = 7;
    mesh.triangle_count = 6;
    mesh.vertices = v;
    mesh.triangles = t;
    return dem_wall_mesh_add(world, m, &mesh);
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("ellipsoids of aspect ratio 10 to 1000 touch at the brute-force scale, the same both "
         "ways, within 40 evaluations") {
        uint64_t seed = 17;
        meet_random(10, &seed);
        meet_random(100, &seed);
        meet_random(1000, &seed);
    }
    TEST("nearly parallel needles and discs, 1e-6 of their thickness apart, touch where brute "
         "force finds") {
        uint64_t seed = 18;
        int way;
        for (way = 0; way < 3; way++) {
            meet_parallel(way, 10, &seed);
            meet_parallel(way, 100, &seed);
            meet_parallel(way, 1000, &seed);
        }
    }
    TEST("aligned and crossed needles and discs of 1000:1 touch at the distance over the sum of "
         "half axes; at 0 when concentric") {
        /* along an axis that both share nothing is tilted: W0 = d/(ha + hb) */
        const dem_quat cross = dem_quat_about(at(0, 1, 0), (dem_real)(pi/2));
        static const double gaps[3] = {0.5, 0.9999, 1.2};
        int i;
        for (i = 0; i < 3; i++) {
            const double g = gaps[i], eps = single ? 1e-6 : 1e-12;
            dem_ellipsoid a = egg(0, 0, 0, 1, 1, 1000, upright()), b = a;
            b.position = at(0, 0, 2000*g);
            CHECK_NEAR(dem_ellipsoids_contact_get(&a, &b, 0).scale, g, eps);
            b.position = at(2*g, 0, 0);
            CHECK_NEAR(dem_ellipsoids_contact_get(&a, &b, 0).scale, g, eps);
            b.position = at(0, 2*g, 0);         /* crossed: thin on thin */
            b.orientation = cross;
            CHECK_NEAR(dem_ellipsoids_contact_get(&a, &b, 0).scale, g, single ? 1e-4 : 1e-9);
            b.position = at(0, 0, 1001*g);      /* tip on side */
            CHECK_NEAR(dem_ellipsoids_contact_get(&a, &b, 0).scale, g, single ? 1e-4 : 1e-9);
            a.semi_axes = b.semi_axes = at(1000, 1000, 1);
            b.orientation = upright();
            b.position = at(0, 0, 2*g);         /* face on face, rim on rim */
            CHECK_NEAR(dem_ellipsoids_contact_get(&a, &b, 0).scale, g, eps);
            b.position = at(2000*g, 0, 0);
            CHECK_NEAR(dem_ellipsoids_contact_get(&a, &b, 0).scale, g, eps);
            b.position = at(0, 0, 0);           /* one in the other */
            b.semi_axes = at(1, 3, 1000);
            CHECK_NEAR(dem_ellipsoids_contact_get(&a, &b, 0).scale, 0, 1e-6);
            CHECK(demi_finite3(dem_ellipsoids_contact_get(&a, &b, 0).normal));
        }
    }
    TEST("needles and discs of 100:1 and 1000:1 collide elastically: the energy error falls as "
         "dt^2, momentum holds to round-off") {
        int way;
        for (way = 0; way < 3; way++) {
            collide_some(100, way, 0);
            /* single precision knows the place of a body of 1000 to 1 no finer than it overlaps */
            if (!single) collide_some(1000, way, 0);
        }
    }
    TEST("needles and discs of 10:1 spinning at 1e5 rad/s collide elastically and keep energy, "
         "momentum and angular momentum") {
        collide_some(10, 0, 1e5);
        collide_some(10, 1, 1e5);
    }
    TEST("a 100:1 needle dropped on its tip rises as fast as it fell, from a plane, a face, an "
         "edge and a vertex alike") {
        falls(at(2e-4, 2e-4, 2e-2), ON_VERTEX);
    }
    TEST("a 100:1 disc dropped flat rises as fast as it fell, from a plane, a face, an edge and a "
         "vertex alike") {
        falls(at(1e-2, 1e-2, 1e-4), ON_VERTEX);
    }
    TEST("an ellipsoid at the centre of another stops the run with an error, and all numbers stay "
         "finite") {
        int way;
        for (way = 0; way < 3; way++) {
            dem_world_desc desc = shapes_desc(1e-7);
            dem_world *world = dem_world_create(&desc);
            const dem_material m = spring_stuff(world, 1e5, 1, 0.3);
            const dem_shape s = dem_shape_ellipsoid_add(world, axes_of(way, 1e-3, 0));
            dem_body b[2];
            int k;
            b[0] = dem_body_add(world, m, s, at(0, 0, 0), upright());
            b[1] = dem_body_add(world, m, s, at(0, 0, 0), way ? upright()
                                : dem_quat_about(at(1, 2, 3), 1));
            CHECK(dem_world_step(world, 5) != DEM_OK);
            CHECK(strlen(dem_world_error_get(world)) > 20);
            for (k = 0; k < 2; k++) {
                const dem_body_state x = scene_state(world, b[k]);
                CHECK(demi_finite3(x.position) && demi_finite3(x.velocity) && demi_finite3(x.spin));
            }
            dem_world_destroy(world);
        }
    }
    TEST("a thousand coincident spheres in one cluster equal one sphere: volume, moments, radius, "
         "fall and rebound") {
        static dem_real x[3000];
        double up[2];
        int which;
        for (which = 0; which < 2; which++) {
            dem_world_desc desc = shapes_desc(2e-6);
            dem_world *world = dem_world_create(&desc);
            const dem_material m = spring_stuff(world, 1e4, 0.6, 0.3);
            dem_shape_info info;
            dem_body b;
            int k;
            for (k = 0; k < 3000; k++) x[k] = (dem_real)(1e-3*(k%3 + 1));
            dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
            if (which) {
                const dem_shape s = cluster_add(world, 1000, x, 2e-3, DEM_CLUSTER_UNION);
                CHECK_EQ(dem_shape_get(world, s, &info), DEM_OK);
                /* 512 rays a side: parts in 1e6 (test_shapes, lens formula) */
                CHECK_REL(info.volume, 4*pi/3*8e-9, 1e-5);
                CHECK_REL(info.inertia.x, 0.4*4*pi/3*8e-9*4e-6, 2e-5);
                CHECK_REL(info.inertia.z, (double)info.inertia.x, 1e-5);
                CHECK_REL(info.radius, 2e-3, single ? 1e-5 : 1e-9);
                CHECK_NEAR(info.centre.y, 2e-3, single ? 1e-8 : 1e-11);
                b = dem_body_add(world, m, s, at(0, 0, 2.01e-3), upright());
            } else b = dem_sphere_add(world, m, DEM_R(2e-3), at(0, 0, 2.01e-3));
            scene_move(world, b, at(0.3, 0, -1), at(0, 100, 0));
            CHECK_EQ(scene_step(world, 250), DEM_OK);
            up[which] = (double)scene_state(world, b).velocity.z;
            if (which) CHECK_NEAR(scene_state(world, b).velocity.x, 0.3, 0.3);
            dem_world_destroy(world);
        }
        /* the dashpot's force jumps at touch: off by beta w dt = .16*.022, for one as for all */
        CHECK_REL(up[0], 0.6, 0.01);
        CHECK_REL(up[1], up[0], 1e-4);          /* as their volumes */
    }
    TEST("a rod of two spheres with moments 1e6:1 rotates freely with constant L and bounces "
         "without gaining energy") {
        /* 1 + 5/2 (L/r)^2 = 1e6 */
        const double r = 1e-4, half = r*sqrt(0.4*(1e6 - 1));
        dem_real x[6] = {0, 0, 0, 0, 0, 0};
        dem_world_desc desc = shapes_desc(2e-7);
        dem_world *world;
        dem_material m;
        dem_shape_info info;
        dem_totals t, u;
        dem_body b;
        dem_shape s;
        double first;
        int k;
        desc.allow_large_dt = 1;            /* advised for a mass of I_min/L^2: 1000 times less */
        world = dem_world_create(&desc);
        m = spring_stuff(world, 1e3, 1, 0);
        x[0] = (dem_real)-half;
        x[3] = (dem_real)half;
        s = cluster_add(world, 2, x, r, DEM_CLUSTER_SUM);
        CHECK_EQ(dem_shape_get(world, s, &info), DEM_OK);
        CHECK_REL((double)info.inertia.z/(double)info.inertia.x, 1e6, single ? 1e-4 : 1e-9);
        b = dem_body_add(world, m, s, at(0, 0, 0.1), upright());
        scene_move(world, b, at(0, 0, 0), at(1e4, 30, 40));
        scene_step(world, 1);
        t = dem_totals_get(world);
        scene_step(world, 20000);
        u = dem_totals_get(world);
        for (k = 0; k < 3; k++)
            CHECK_NEAR(u.angular[k], t.angular[k], fabs(t.angular[2])*(single ? 1e-3 : 1e-10));
        dem_wall_plane_add(world, m, at(0, 0, 0.0997), at(0, 0, 1));   /* one end falls on it */
        { /* lies along x again; turns so that the right end goes down */
            dem_body_state s0 = scene_state(world, b);
            s0.orientation = upright();
            s0.spin = at(0, 30, 0);
            CHECK_EQ(dem_body_set(world, b, &s0), DEM_OK);
        }
        scene_step(world, 1);
        first = stored(world);
        CHECK_EQ(scene_step(world, 20000), DEM_OK);
        CHECK(dem_counters_get(world).overlap_max > 0);
        /* met and left in mid-step: (w dt)^2/8, half of the mass being at that end */
        CHECK_REL(stored(world), first, 1e3/(t.mass/2)*4e-14/8 + (single ? 1e-3 : 0));
        dem_world_destroy(world);
    }
    TEST("two interlocked hooks of spheres hang: the lower one loads the fixed upper one with its "
         "weight") {
        dem_real x[39], y[39];
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material m;
        dem_contact_info c[20];
        dem_shape_info up, down;
        dem_body_state s;
        dem_body a, b;
        dem_shape shape[2];
        double pull = 0, most = 0;
        int n, k, round;
        desc.threads = 1;
        desc.gravity = at(0, 0, -9.81);
        world = dem_world_create(&desc);
        m = scene_material(world, 1e7, 0.3, 0.5, 0.1);
        n = hook(x, 1);
        hook(y, -1);
        shape[0] = cluster_add(world, n, x, 1e-3, DEM_CLUSTER_UNION);
        shape[1] = cluster_add(world, n, y, 1e-3, DEM_CLUSTER_UNION);
        dem_shape_get(world, shape[0], &up);
        dem_shape_get(world, shape[1], &down);
        /* the lower one stands across, turned by 90 degrees about z: its top in the other */
        a = dem_body_add(world, m, shape[0], up.centre, upright());
        s = scene_state(world, a);
        s.fixed = 1;
        dem_body_set(world, a, &s);
        b = dem_body_add(world, m, shape[1], demi_add(at(0, 0, -5.95e-3),
            dem_quat_rotate(dem_quat_about(at(0, 0, 1), (dem_real)(pi/2)), down.centre)),
            dem_quat_about(at(0, 0, 1), (dem_real)(pi/2)));
        for (round = 0; round < 10; round++) CHECK_EQ(dem_world_run(world, 0.1, 0, 0), DEM_OK);
        CHECK_EQ(dem_candidates_rebuild(world), DEM_OK);
        n = dem_contacts_get(world, c, 20);
        CHECK(n >= 1 && n <= 20);
        for (k = 0; k < n && k < 20; k++)
            pull += (c[k].a.slot == b.slot ? 1 : -1)*(double)c[k].force.z;
        s = scene_state(world, b);
        most = (double)s.mass*9.81;
        CHECK_REL(pull, most, 0.02);
        CHECK((double)s.position.z > -12e-3);   /* it did not fall */
        CHECK((double)demi_length(s.velocity) < 0.01);
        dem_world_destroy(world);
    }
    TEST("a cluster of four balls dropped into the corner of a mesh box rests there, and three "
         "faces bear its weight") {
        static const dem_real x[12] = {0, 0, 0, DEM_R(4e-3), 0, 0, 0, DEM_R(3e-3), 0, 0, 0,
                                       DEM_R(3.5e-3)};
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material m;
        dem_wall corner;
        dem_wall_loads load;
        dem_body_state s;
        dem_body b;
        double weight;
        desc.threads = 1;
        desc.gravity = at(-9.81/sqrt(3.0), -9.81/sqrt(3.0), -9.81/sqrt(3.0));
        world = dem_world_create(&desc);
        m = scene_material(world, 1e7, 0.3, 0.3, 0.05);
        corner = trough_add(world, m, 0.05);
        CHECK(corner.id);
        b = dem_body_add(world, m, cluster_add(world, 4, x, 2e-3, DEM_CLUSTER_UNION),
                         at(0.008, 0.009, 0.0085), dem_quat_about(at(1, 3, 2), 1));
        CHECK_EQ(dem_world_run(world, 0.5, 0, 0), DEM_OK);
        dem_wall_loads_reset(world, corner);
        CHECK_EQ(dem_world_run(world, 0.1, 0, 0), DEM_OK);
        CHECK_EQ(dem_wall_loads_get(world, corner, &load), DEM_OK);
        s = scene_state(world, b);
        weight = (double)s.mass*9.81/sqrt(3.0);
        /* what is left of its speed over that time: v/(g t), v of mm/s */
        CHECK_REL(load.impulse[0]/load.time, -weight, 0.02);
        CHECK_REL(load.impulse[1]/load.time, -weight, 0.02);
        CHECK_REL(load.impulse[2]/load.time, -weight, 0.02);
        CHECK((double)demi_length(s.velocity) < 2e-3);
        CHECK(s.position.x > 0 && s.position.y > 0 && s.position.z > 0);
        dem_world_destroy(world);
    }
    TEST("a pile of spheres, needles, discs and clusters comes to rest, but for vertical spin, "
         "and its floor bears the weight") {
        static const dem_real three[9] = {DEM_R(-2e-3), 0, 0, DEM_R(2e-3), 0, 0, 0, DEM_R(3e-3), 0};
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material m;
        dem_shape shape[3];
        dem_wall floor;
        dem_wall_loads load;
        dem_totals t;
        double kinetic[3], twirl[3];
        const double at_rest = single ? 1e-12 : 1e-15;     /* J: some 1e-6 m/s of a grain */
        const int all = getenv("TEST_LONG") != 0, count = all ? 96 : 24;
        uint64_t seed = 4;
        int i, k;
        desc.threads = 1;
        desc.gravity = at(0, 0, -9.81);
        world = dem_world_create(&desc);
        /* hard enough that needles do not sink into the floor by their thickness, tip first */
        m = scene_material(world, all ? 1e8 : 3e6, 0.3, 0.5, 0.1);
        shape[0] = dem_shape_ellipsoid_add(world, at(1e-3, 1e-3, 1e-2));
        shape[1] = dem_shape_ellipsoid_add(world, at(6e-3, 6e-3, 6e-4));
        shape[2] = cluster_add(world, 3, three, 2e-3, DEM_CLUSTER_UNION);
        floor = dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        dem_wall_cylinder_add(world, m, at(0, 0, 0), at(0, 0, 1), DEM_R(0.03), 1);
        for (i = 0; i < count; i++) {
            const double a = 2*pi*(i%6)/6, r = 0.018;
            const dem_vec3 x = at(r*cos(a), r*sin(a), 0.012 + 0.014*(i/6));
            if (i%4 == 3) dem_sphere_add(world, m, DEM_R(3e-3), x);
            else dem_body_add(world, m, shape[i%4], x, random_turn(&seed));
        }
        for (k = 0; k < 3; k++) {
            CHECK_EQ(dem_world_run(world, (all ? 5 : 1)*(k ? 0.08 : 0.16), 0, 0), DEM_OK);
            t = dem_totals_get(world);
            twirl[k] = 0;
            for (i = 0; i < count; i++) {
                const dem_bodies b = dem_bodies_get(world);
                const double r = (double)b.positions[4*i + 3], spin = (double)b.spins[4*i + 2];
                if (!b.shapes[i] && fabs((double)b.positions[4*i + 2] - r) < r/100)
                    twirl[k] += mass_of(r, r, r)*r*r/5*spin*spin;
            }
            kinetic[k] = t.kinetic + t.rotational - twirl[k];
        }
        dem_wall_loads_reset(world, floor);
        CHECK_EQ(dem_world_run(world, 0.1, 0, 0), DEM_OK);
        dem_wall_loads_get(world, floor, &load);
        CHECK_REL(-load.impulse[2]/load.time, t.mass*9.81, 0.03);
        for (k = 1; k < 3; k++) {
            CHECK(kinetic[k] < kinetic[k - 1] || kinetic[k] < at_rest);
            CHECK(twirl[k] <= twirl[k - 1]*(1 + 1e-12) || kinetic[k - 1] > 1e-9 || twirl[k] < at_rest);
        }
        CHECK_EQ(dem_body_counts_get(world).present, count);
        dem_world_destroy(world);
    }
    return test_end();
}
