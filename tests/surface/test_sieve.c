/* Sieves: wires and plates against their geometry and against probability, what must never pass,
   what gets stuck, and the reduced hole of the screening machine's thesis.
   The environment variable TEST_LONG has the leak tests go on for 1e7 contacts with wires. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static dem_sieve_desc sieve_of(dem_sieve_kind kind, double aperture, double bar) {
    dem_sieve_desc s = DEM_SIEVE_DESC;
    s.kind = kind;
    s.aperture = (dem_real)aperture;
    s.bar = (dem_real)bar;
    return s;
}
static dem_world *world_of(double g, double dt) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.normal_law = DEM_NORMAL_LINEAR;
    desc.gravity = at(0, 0, -g);
    desc.dt = (dem_real)dt;
    desc.threads = 1;
    return dem_world_create(&desc);
}
static dem_material stiff(dem_world *world, double stiffness, double e, double mu) {
    dem_material_desc m = DEM_MATERIAL_DESC;
    m.density = 2500;
    m.poisson = DEM_R(0.25);
    m.stiffness = (dem_real)stiffness;
    m.restitution = (dem_real)e;
    m.friction = (dem_real)mu;
    return dem_material_add(world, &m);
}
/* A ball that just does not fit a hole of 1 cm, with a smaller one on it. */
static dem_body headed_add(dem_world *world, dem_material stuff, dem_vec3 place) {
    static const dem_real places[6] = {0, 0, 0, 0, 0, DEM_R(0.004)};
    static const dem_real radii[2] = {DEM_R(0.0051), DEM_R(0.003)};
    dem_cluster_desc cluster = DEM_CLUSTER_DESC;
    cluster.count = 2;
    cluster.positions = places;
    cluster.radii = radii;
    return dem_body_add(world, stuff, dem_shape_cluster_add(world, &cluster), place,
                        dem_quat_make(1, 0, 0, 0));
}
/* Share of spheres of radius r, placed at random over whole holes, that fit through: untouched half
   way through, where the room is narrowest. */
static double rain(const dem_sieve_desc *s, double r, int count, uint64_t seed) {
    demi_touching c[DEMI_SIEVE_MOST];
    const double x = 10*(double)(s->aperture + s->bar);
    int i, passed = 0;
    for (i = 0; i < count; i++) {
        const double a = x*scene_random(&seed), b = x*scene_random(&seed);
        passed += demi_sieve_touch(s, at(a, b, 0), (dem_real)r, 0, c) == 0;
    }
    return (double)passed/count;
}
/* A normal that belongs to the same place of a sieve as c, among those of a sphere nearby; 0: none. */
static const demi_touching *same_place(const demi_touching *c, const demi_touching *near, int count) {
    int i;
    for (i = 0; i < count; i++)
        if (near[i].element == c->element && demi_dot(near[i].normal, c->normal) > DEM_R(0.99))
            return &near[i];
    return 0;
}
/* Of how many contacts (of *seen) of spheres at random the normal turns otherwise than demi_sieve_bend
   says, by differences over a short way; but where it has a kink there, and about the middle of what
   goes round it, where turning is held back. */
static int turned_otherwise(const dem_sieve_desc *s, int *seen) {
    const double step = DEMI_SINGLE ? 3e-3 : 1e-5;
    demi_touching c[5][DEMI_SIEVE_MOST];
    demi_wall wall;
    uint64_t seed = 5;
    int i, j, k, off = 0;
    memset(&wall, 0, sizeof wall);
    wall.sieve = *s;
    for (i = *seen = 0; i < 4000; i++) {
        const dem_vec3 x = scene_at(&seed, 20, -10, 20, -10, 2, -1);
        const dem_vec3 u = scene_at(&seed, 2, -1, 2, -1, 2, -1);
        const double r = 0.5 + 0.6*scene_random(&seed);
        int count[5];
        for (j = 0; j < 5; j++)
            count[j] = demi_sieve_touch(s, demi_add(x, demi_scale(u, (dem_real)(step*(j - 2)))),
                                        (dem_real)r, 0, c[j]);
        for (k = 0; k < count[2]; k++) {
            const demi_touching *at[5];
            dem_vec3 seems, wide, across, said;
            demi_bend b;
            for (j = 0; j < 5 && (at[j] = same_place(&c[2][k], c[j], count[j])) != 0; j++) {}
            if (j < 5) continue;
            seems = demi_scale(demi_sub(at[3]->normal, at[1]->normal), (dem_real)(0.5/step));
            wide = demi_scale(demi_sub(at[4]->normal, at[0]->normal), (dem_real)(0.25/step));
            memset(&b, 0, sizeof b);
            b.number = c[2][k].element;
            b.dist = (dem_real)r - c[2][k].overlap;
            b.normal = c[2][k].normal;
            b.point = c[2][k].point;
            if (!(demi_length(demi_sub(seems, wide)) < 1e-2) || !(b.dist > 0.1)) continue;
            demi_sieve_bend(&wall, 0, 0, &b);
            if (fabs((double)b.along) > 5 || demi_length(seems) > 3) continue;
            across = demi_sub(u, demi_scale(b.normal, demi_dot(u, b.normal)));
            across = demi_sub(across, demi_scale(b.axis, demi_dot(u, b.axis)));
            said = demi_add(demi_scale(across, b.turn),
                            demi_scale(b.axis, b.along*demi_dot(u, b.axis)));
            ++*seen;
            off += !(demi_length(demi_sub(seems, said)) < 0.02*(1 + demi_length(seems)));
        }
    }
    return off;
}
static double sigma(double p, int count) { return sqrt(p*(1 - p)/count); }

/* Sum of share*overlap*normal of a sphere: the force of springs of 1 N/m. */
static dem_vec3 spring_force(const dem_sieve_desc *s, dem_vec3 x, double r) {
    demi_touching c[DEMI_SIEVE_MOST];
    dem_vec3 f = at(0, 0, 0);
    const int n = demi_sieve_touch(s, x, (dem_real)r, 0, c);
    int i;
    for (i = 0; i < n; i++) f = demi_sub(f, demi_scale(c[i].normal, c[i].overlap*c[i].share));
    return f;
}

/* A shaking sieve on which grains lie about, each alone, under a lid when lid > 0 (m). */
typedef struct shaking {
    dem_sieve_desc sieve;
    double d, stiffness, friction, amplitude, frequency, lid;
    int grains, periods;
    double period;
    uint64_t seed;
    double overlap;
} shaking;
static shaking shaking_of(dem_sieve_desc sieve, double d) {
    shaking q;
    memset(&q, 0, sizeof q);
    q.sieve = sieve;
    q.d = d;
    q.stiffness = 1e5;
    q.grains = 100;
    q.periods = 1;
    q.period = 0.5;
    q.seed = 5;
    return q;
}
/* Shakes it; after every period, how many are left above it, in out. Answers the number of contacts
   with the sieve that began (as seen at every tenth step: never too many). overlap: the largest,
   over the radius. */
static double shake(shaking *q, int *out) {
    const double dt = q->stiffness > 5e4 ? 1e-5 : 2e-5, d = q->d;
    dem_world *world = world_of(9.81, dt);
    dem_material stuff = stiff(world, q->stiffness, 0.5, q->friction);
    dem_motion motion = DEM_MOTION;
    dem_sieve_desc s = q->sieve;
    const double pitch = (double)(s.aperture + s.bar), apart = 3.7*d + pitch;
    const int row = (int)ceil(sqrt(q->grains));
    dem_wall wall;
    double began = 0;
    int i, k, before = 0;
    uint64_t seed = q->seed;
    s.radius = (dem_real)(apart*row + 20*pitch);
    wall = dem_wall_sieve_add(world, stuff, &s);
    motion.kind = DEM_MOTION_OSCILLATING;
    motion.velocity = at(0.3, 0.2, 1);
    motion.amplitude = (dem_real)q->amplitude;
    motion.frequency = (dem_real)q->frequency;
    dem_wall_motion_set(world, wall, &motion);
    if (q->lid > 0) dem_wall_plane_add(world, stuff, at(0, 0, q->lid), at(0, 0, -1));
    for (i = 0; i < 4; i++) {                    /* a fence on the sieve keeps them over it */
        const dem_wall fence = dem_wall_plane_add(world, stuff,
            at(i == 0 ? -5*pitch : i == 1 ? apart*row : 0, i == 2 ? -5*pitch : i == 3 ? apart*row : 0, 0),
            at(i == 0 ? 1 : i == 1 ? -1 : 0, i == 2 ? 1 : i == 3 ? -1 : 0, 0));
        dem_wall_motion_set(world, fence, &motion);
    }
    for (i = 0; i < q->grains; i++) {
        const double x = apart*(i%row) + pitch*scene_random(&seed);
        const double y = apart*(i/row) + pitch*scene_random(&seed);
        const double z = q->lid > 0 ? q->lid - 0.6*d
            : d/2 + (double)s.bar + pitch*(0.2 + scene_random(&seed));
        dem_sphere_add(world, stuff, (dem_real)(d/2), at(x, y, z));
    }
    for (k = 0; k < q->periods; k++) {
        const int steps = (int)(q->period/dt/10 + 0.5);
        dem_bodies b;
        for (i = 0; i < steps; i++) {
            dem_wall_loads c;
            memset(&c, 0, sizeof c);
            if (scene_step(world, 10) != DEM_OK) { CHECK(0); break; }
            dem_wall_loads_get(world, wall, &c);
            began += c.contacts > before ? c.contacts - before : 0;
            before = c.contacts;
        }
        b = dem_bodies_get(world);
        for (out[k] = 0, i = 0; i < b.count; i++) out[k] += (double)b.positions[4*i + 2] > -5*d;
    }
    q->overlap = (double)dem_counters_get(world).overlap_max;
    dem_world_destroy(world);
    return began;
}

int main(int argc, char **argv) {
    const int n = 100000;
    test_begin(argc, argv);

    TEST("rain on a square weave: a fraction ((a - d)/(a + w))^2 of spheres passes untouched (Gaudin)") {
        static const double rows[3][4] = {{1, 0.5, 0.5, 0.11111}, {1, 0.5, 0.8, 0.017778},
                                          {2, 1, 1.5, 0.027778}};
        int i;
        for (i = 0; i < 3; i++) {
            const dem_sieve_desc s = sieve_of(DEM_SIEVE_WIRES, rows[i][0], rows[i][1]);
            CHECK_NEAR(rain(&s, rows[i][2]/2, n, 7), rows[i][3], 3*sigma(rows[i][3], n));
        }
    }

    TEST("rain on slots, square and round holes passes in the fraction of open area") {
        const double a = 1, w = 0.5, d = 0.6, pi = 3.14159265358979;
        dem_sieve_desc s = sieve_of(DEM_SIEVE_SLOTS, a, w);
        double p = (a - d)/(a + w);
        CHECK_NEAR(rain(&s, d/2, n, 8), p, 3*sigma(p, n));
        s.length = DEM_R(4.5);
        s.thickness = DEM_R(0.4);
        p *= (4.5 - d)/(4.5 + w);
        CHECK_NEAR(rain(&s, d/2, n, 9), p, 3*sigma(p, n));
        s = sieve_of(DEM_SIEVE_SQUARE, a, w);
        p = (a - d)*(a - d)/((a + w)*(a + w));
        CHECK_NEAR(rain(&s, d/2, n, 10), p, 3*sigma(p, n));
        s = sieve_of(DEM_SIEVE_BARS, a, w);
        p = (a - d)/(a + w);
        CHECK_NEAR(rain(&s, d/2, n, 11), p, 3*sigma(p, n));
        s = sieve_of(DEM_SIEVE_ROUND, a, w);
        p = pi*(a - d)*(a - d)/4/((a + w)*(a + w));
        CHECK_NEAR(rain(&s, d/2, n, 12), p, 3*sigma(p, n));
        s.staggered = 1;
        p *= 2/sqrt(3.0);
        CHECK_NEAR(rain(&s, d/2, n, 13), p, 3*sigma(p, n) + 0.01*p);   /* rows are cut */
    }

    TEST("the grains that fall through a weave untouched are those that geometry predicts, one by one") {
        const dem_sieve_desc s = sieve_of(DEM_SIEVE_WIRES, 0.01, 0.004);
        dem_world *world = world_of(9.81, 1e-5);
        dem_material stuff = stiff(world, 1e4, 0.5, 0.3);
        uint64_t seed = 3;
        int i, k, touched[400] = {0}, agree = 0, pass = 0;
        dem_bodies b;
        dem_wall_sieve_add(world, stuff, &s);
        for (i = 0; i < 400; i++) {
            const double x = 0.05*(i%20) + 0.014*scene_random(&seed);
            const double y = 0.05*(i/20) + 0.014*scene_random(&seed);
            dem_sphere_add(world, stuff, DEM_R(0.003), at(x, y, 0.008));
        }
        for (k = 0; k < 8000; k++) {
            dem_contact_info info[800];
            int m;
            CHECK_EQ(scene_step(world, 1), DEM_OK);
            if (k%4) continue;
            m = dem_contacts_get(world, info, 800);
            for (i = 0; i < m && i < 800; i++) touched[info[i].a.slot - 1] = 1;
        }
        b = dem_bodies_get(world);
        seed = 3;
        {
            demi_touching c[DEMI_SIEVE_MOST];
            int untouched[400];
            for (i = 0; i < 400; i++) {
                const double x = 0.05*(i%20) + 0.014*scene_random(&seed);
                const double y = 0.05*(i/20) + 0.014*scene_random(&seed);
                untouched[i] = demi_sieve_touch(&s, at(x, y, 0), DEM_R(0.003), 0, c) == 0;
            }
            for (i = 0; i < b.count; i++) {
                const int slot = (int)b.slots[i];
                agree += untouched[slot] == !touched[slot];
                pass += untouched[slot];
                if (untouched[slot]) CHECK((double)b.positions[4*i + 2] < -0.01);
            }
        }
        CHECK_EQ(agree, 400);
        CHECK(pass > 15 && pass < 60);           /* 400 (4/14)^2 = 33 */
        dem_world_destroy(world);
    }

    TEST("on a plate, between distant wires and above crossings a grain feels one wall's force") {
        dem_sieve_desc s = sieve_of(DEM_SIEVE_SQUARE, 1, 1);
        dem_vec3 f;
        s.thickness = DEM_R(0.2);
        f = spring_force(&s, at(0.9, 0.3, 0.1 + 0.29), 0.3);           /* on a bar */
        CHECK_NEAR(f.z, 0.01, 1e-6);
        f = spring_force(&s, at(0.9, 0.9, 0.1 + 0.29), 0.3);           /* where bars meet */
        CHECK_NEAR(f.z, 0.01, 1e-6);
        f = spring_force(&s, at(0.9, 0.3, -0.1 - 0.29), 0.3);          /* from below */
        CHECK_NEAR(f.z, -0.01, 1e-6);
        s = sieve_of(DEM_SIEVE_WIRES, 1, 0.2);
        f = spring_force(&s, at(0.6, 0.2, 0.39), 0.3);                 /* on a wire at x = .6 */
        CHECK_NEAR(f.z, 0.01, 1e-6);
        CHECK_NEAR(f.x, 0, 1e-9);
        f = spring_force(&s, at(0.6, 0.6, 0.39), 0.3);                 /* on two that cross */
        CHECK_NEAR(f.z, 0.01, 1e-6);
        s.lift = DEM_R(0.2);
        f = spring_force(&s, at(0.6, 0.6, 0.49), 0.3);                 /* one on the other */
        CHECK_NEAR(f.z, 0.01, 1e-6);
        s = sieve_of(DEM_SIEVE_ROUND, 1, 0.5);
        f = spring_force(&s, at(0, 0, 0.4), 0.65);                     /* too large: sits on the rim */
        CHECK(f.z > DEM_R(0.005));
        CHECK_NEAR(f.x, 0, 1e-6);
    }

    TEST("a contact normal turns with position as its curvature says, on wires, ends, crossings, strips, corners and "
         "rims") {
        static const dem_sieve_kind kinds[] = {
            DEM_SIEVE_WIRES, DEM_SIEVE_BARS, DEM_SIEVE_SQUARE, DEM_SIEVE_ROUND, DEM_SIEVE_SLOTS,
            DEM_SIEVE_REDUCED};
        int k, how;
        for (k = 0; k < (int)(sizeof kinds/sizeof kinds[0]); k++)
            for (how = 0; how < 3; how++) {     /* endless; cut off by a disc; lifted, or thick */
                dem_sieve_desc s = sieve_of(kinds[k], 1.7, 0.6);
                int seen, off;
                if (s.kind == DEM_SIEVE_REDUCED && how != 1) continue;
                if (s.kind == DEM_SIEVE_SLOTS) s.length = 4;
                if (how > 0) s.radius = 8;
                if (how > 1 && s.kind == DEM_SIEVE_WIRES) s.lift = DEM_R(0.3);
                if (how > 1 && s.kind > DEM_SIEVE_BARS) s.thickness = DEM_R(0.5);
                off = turned_otherwise(&s, &seen);
                CHECK(seen > 1000);
                CHECK_EQ(off, 0);
            }
    }
    TEST("the force on a grain is continuous along any path over wires, rims and crossings") {
        static const dem_sieve_kind kinds[5] = {DEM_SIEVE_WIRES, DEM_SIEVE_SQUARE, DEM_SIEVE_ROUND,
                                                DEM_SIEVE_SLOTS, DEM_SIEVE_BARS};
        uint64_t seed = 2;
        int i, k, way;
        double worst = 0;
        for (k = 0; k < 5; k++)
            for (way = 0; way < 60; way++) {
                dem_sieve_desc s = sieve_of(kinds[k], 1, 0.6);
                const double r = 0.25 + 0.6*scene_random(&seed);
                const double z = r + (k == 0 || k == 4 ? 0.3 : 0) - 0.02*r;
                const double x0 = 3*scene_random(&seed), y0 = 3*scene_random(&seed);
                const double a = 6.2831853*scene_random(&seed), h = 1e-5;
                dem_vec3 before = at(0, 0, 0);
                if (k == 3) s.length = 2;
                for (i = 0; i < 20000; i++) {    /* pressed in by 2 %, along a line of .2 m */
                    const dem_vec3 f = spring_force(&s, at(x0 + i*h*cos(a), y0 + i*h*sin(a), z), r);
                    const double jump = (double)demi_length(demi_sub(f, before));
                    if (i && jump > worst) worst = jump;
                    before = f;
                }
            }
        CHECK_NEAR(worst, 0, 2e-5);              /* springs of 1 N/m: about one h, of .02 r in all */
    }

    TEST("grains larger than the holes never pass, however the sieve shakes") {
        static const struct { dem_sieve_kind kind; double amplitude, frequency, mu; } rows[5] = {
            {DEM_SIEVE_WIRES, 0.002, 30, 0.3}, {DEM_SIEVE_WIRES, 0.0005, 150, 0},
            {DEM_SIEVE_ROUND, 0.002, 30, 0.3}, {DEM_SIEVE_SQUARE, 0.002, 30, 0.1},
            {DEM_SIEVE_SLOTS, 0.001, 60, 0.3}};
        const int longer = getenv("TEST_LONG") != 0;
        double contacts = 0, wires = 0;
        int i;
        for (i = 0; i < 5; i++) {
            const double wanted = !longer ? 0 : rows[i].kind == DEM_SIEVE_WIRES ? 5e6 : 1e6;
            double here = 0;
            int left = 0;
            shaking q = shaking_of(sieve_of(rows[i].kind, 0.01, 0.004), 0.0104);
            q.friction = rows[i].mu;
            q.amplitude = rows[i].amplitude;
            q.frequency = rows[i].frequency;
            /* high enough that nothing is crushed, not even one grain on another on a crossing.
               What a lid at 12.5 mm presses in by .18 of its radius, or one at 15.5 mm by .08, can
               be shot through a hole 4 % too small, and now and then is */
            q.lid = 0.03;
            if (longer) q.period = 20;
            for (; here <= wanted; q.seed++) {   /* every time from another start */
                here += shake(&q, &left);
                CHECK_EQ(left, 100);
                CHECK(q.overlap < 0.035);        /* .2 mm of 5.2 mm would let it pass */
            }
            contacts += here;
            if (rows[i].kind == DEM_SIEVE_WIRES) wires += here;
        }
        CHECK(contacts > 3e3);
        if (longer) printf("%.3g contacts, %.3g of them with wires\n", contacts, wires);
    }

    TEST("grains that barely fit pass in the end without friction") {
        shaking q = shaking_of(sieve_of(DEM_SIEVE_WIRES, 0.01, 0.004), 0.01*(1 - 1e-6));
        int left[8];
        q.amplitude = 0.0003;
        q.frequency = 25;
        q.grains = 36;
        q.periods = 8;
        q.period = 0.25;
        shake(&q, left);
        CHECK_EQ(left[7], 0);
    }

    TEST("single grains on a shaking weave remain in geometric progression: first-order sieving") {
        shaking q = shaking_of(sieve_of(DEM_SIEVE_WIRES, 0.01, 0.005), 0.0085);
        int left[12], i, first = 2, m = 0;       /* straight once those over a hole are through */
        double sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0, r2;
        q.stiffness = 2e4;
        q.friction = 0.2;
        q.amplitude = 0.0015;
        q.frequency = 35;
        q.grains = 1700;
        q.periods = 12;
        q.period = 0.12;
        shake(&q, left);
        for (i = first; i < 12 && left[i] > 30; i++) {      /* until numbers are small */
            const double x = i, y = log((double)left[i]);
            sx += x; sy += y; sxx += x*x; sxy += x*y; syy += y*y; m++;
        }
        CHECK(m >= 5);
        r2 = (m*sxy - sx*sy)*(m*sxy - sx*sy)/((m*sxx - sx*sx)*(m*syy - sy*sy));
        CHECK(sxy*m < sx*sy);
        CHECK_NEAR(r2, 1, 0.01);
    }

    TEST("a near-size grain pressed into a hole is stuck, and counted, only where friction can hold "
         "it") {
        static const double mu[3] = {0.5, 0, 0.5};
        int i;
        for (i = 0; i < 3; i++) {                /* the third has a head on it */
            const dem_sieve_desc s = sieve_of(DEM_SIEVE_WIRES, 0.01, 0.004);
            dem_world *world = world_of(9.81, 1e-5);
            dem_material stuff = stiff(world, i == 2 ? 5e4 : 1e5, 0.4, mu[i]);
            dem_wall wall = dem_wall_sieve_add(world, stuff, &s);
            dem_body grain = i == 2 ? headed_add(world, stuff, at(0, 0, 0.006))
                : dem_sphere_add(world, stuff, DEM_R(0.0051), at(0, 0, 0.006));
            dem_body rests = dem_sphere_add(world, stuff, DEM_R(0.009), at(0.07, 0.07, 0.0115));
            CHECK_EQ(dem_sieve_blinded_get(world, wall, 0), -1);
            scene_move(world, grain, at(0, 0, -1), at(0, 0, 0));
            scene_step(world, 30000);
            CHECK_EQ(dem_sieve_blinded_get(world, wall, DEM_R(0.05)), i == 1 ? 0 : 1);
            CHECK((double)scene_state(world, rests).position.z > 0.005);   /* rests on, not in */
            CHECK_NEAR(scene_state(world, grain).position.z, 0.002, 0.002);
            scene_move(world, grain, at(0, 0, 0.15), at(0, 0, 0));     /* a knock from below */
            scene_step(world, 300);
            CHECK((double)scene_state(world, grain).position.z > (i == 1 ? 0.002 : 0));
            dem_world_destroy(world);
        }
    }

    TEST("elastic bounces on crossings and corners keep energy to 3.5 overlaps per radius, on bars and round holes to "
         "1e-3") {
        static const dem_sieve_kind kinds[4] = {DEM_SIEVE_WIRES, DEM_SIEVE_SQUARE, DEM_SIEVE_BARS,
                                                DEM_SIEVE_ROUND};
        static const double stiffness[2] = {2e3, 2e5};
        int i, j, k;
        for (i = 0; i < 4; i++) for (j = 0; j < 2; j++) for (k = 0; k < 36; k++) {
            dem_world *world = world_of(0, 5e-5*sqrt(2e3/stiffness[j]));
            dem_material stuff = stiff(world, stiffness[j], 1, 0);
            const dem_sieve_desc s = sieve_of(kinds[i], 0.01, 0.003);
            dem_body grain;
            double e, over;
            dem_wall_sieve_add(world, stuff, &s);
            grain = dem_sphere_add(world, stuff, DEM_R(0.012),
                                   at(0.013*(k%6 + 0.5)/6, 0.013*(k/6 + 0.5)/6, 0.016));
            scene_move(world, grain, at(0.15, 0.1, -0.5), at(0, 0, 0));
            CHECK_EQ(scene_step(world, (int)(0.08/(5e-5*sqrt(2e3/stiffness[j])))), DEM_OK);
            e = (double)demi_dot(scene_state(world, grain).velocity,
                                 scene_state(world, grain).velocity)/(0.15*0.15 + 0.01 + 0.25);
            over = (double)dem_counters_get(world).overlap_max;
            CHECK((double)scene_state(world, grain).position.z > 0.013);
            CHECK_NEAR(e, 1, i < 2 ? 3.5*over : 1e-3);
            dem_world_destroy(world);
        }
    }

    TEST("a grain that rolls over a sieve's rim, or flies against it, gains no energy") {
        static const dem_sieve_kind kinds[5] = {DEM_SIEVE_SQUARE, DEM_SIEVE_ROUND, DEM_SIEVE_SLOTS,
                                                DEM_SIEVE_WIRES, DEM_SIEVE_REDUCED};
        int i, k;
        for (i = 0; i < 5; i++)
            for (k = 0; k < 8; k++) {            /* over it, and at it from the side, eight ways */
                const double a = 0.1 + k*0.77, c = k%2 ? -1 : 1, height = k%2 ? 0.0007*k - 0.003 : 0.0045;
                dem_world *world = world_of(0, 1e-5);
                dem_material stuff = stiff(world, 1e4, 0.5, 0.2);
                dem_sieve_desc s = sieve_of(kinds[i], 0.02, 0.005);
                dem_body grain;
                double speed;
                s.radius = DEM_R(0.05);
                if (kinds[i] == DEM_SIEVE_REDUCED) {
                    s.model = 2;
                    s.clearance = DEM_R(0.5);
                } else if (kinds[i] != DEM_SIEVE_WIRES) s.thickness = DEM_R(0.002);
                CHECK(dem_wall_sieve_add(world, stuff, &s).id > 0);
                grain = dem_sphere_add(world, stuff, DEM_R(0.003),
                                       at((k%2 ? 0.056 : 0.045)*cos(a), (k%2 ? 0.056 : 0.045)*sin(a), height));
                scene_move(world, grain, at(0.3*c*cos(a), 0.3*c*sin(a), k%2 ? 0 : -0.1), at(0, 0, 0));
                CHECK_EQ(scene_step(world, 5000), DEM_OK);
                speed = (double)demi_length(scene_state(world, grain).velocity);
                CHECK(speed < sqrt(0.3*0.3 + 0.1*0.1)*(1 + 1e-6));
                dem_world_destroy(world);
            }
    }

    TEST("a cluster of one sphere presses on a wire, and passes a reduced hole, as that sphere does") {
        static const dem_real middle[3] = {0, 0, 0};
        dem_real height[2][2];
        int i, k;
        for (i = 0; i < 2; i++) for (k = 0; k < 2; k++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_sieve_desc s = sieve_of(k ? DEM_SIEVE_REDUCED : DEM_SIEVE_BARS, 0.02, 0.004);
            dem_cluster_desc cluster = DEM_CLUSTER_DESC;
            dem_material stuff;
            dem_world *world;
            dem_body grain;
            const dem_vec3 place = at(k ? 0 : 0.012, 0, 0.0069);
            desc.gravity = at(0, 0, -9.81);
            desc.dt = DEM_R(5e-6);
            world = dem_world_create(&desc);          /* Hertz: R* matters */
            stuff = scene_material(world, 1e6, 0.3, 0, 0);
            if (k) { s.model = 2; s.clearance = DEM_R(0.5); }
            CHECK(dem_wall_sieve_add(world, stuff, &s).id > 0);
            cluster.count = 1;
            cluster.positions = middle;
            cluster.radius = DEM_R(0.005);
            grain = i ? dem_body_add(world, stuff, dem_shape_cluster_add(world, &cluster), place,
                                     dem_quat_make(1, 0, 0, 0))
                : dem_sphere_add(world, stuff, DEM_R(0.005), place);
            CHECK_EQ(scene_step(world, 2000), DEM_OK);
            height[i][k] = scene_state(world, grain).position.z;
            dem_world_destroy(world);
        }
        CHECK_NEAR(height[1][0], (double)height[0][0], 1e-8);
        CHECK_NEAR(height[1][1], (double)height[0][1], 1e-8);
        CHECK((double)height[0][0] < 0.007 && (double)height[0][0] > 0.0065);
    }

    TEST("an endless oscillating sieve needs no list rebuild every step") {
        dem_world *world = world_of(9.81, 1e-5);
        dem_material stuff = stiff(world, 1e4, 0.3, 0);
        const dem_sieve_desc s = sieve_of(DEM_SIEVE_WIRES, 0.004, 0.002);
        const dem_wall wall = dem_wall_sieve_add(world, stuff, &s);
        dem_motion motion = DEM_MOTION;
        motion.kind = DEM_MOTION_OSCILLATING;
        motion.velocity = at(0, 0, 1);
        motion.amplitude = DEM_R(0.0005);
        motion.frequency = 30;
        dem_wall_motion_set(world, wall, &motion);
        dem_sphere_add(world, stuff, DEM_R(0.01), at(0, 0, 0.011));
        CHECK_EQ(scene_step(world, 3000), DEM_OK);
        CHECK((int)dem_counters_get(world).rebuilds < 300);
        dem_world_destroy(world);
    }

    TEST("a cluster partly inside a reduced hole gains no energy") {
        static const dem_real places[6] = {DEM_R(-0.003), 0, 0, DEM_R(0.003), 0, 0};
        int i;
        for (i = 0; i < 6; i++) {
            dem_world *world = world_of(9.81, 1e-5);
            dem_material stuff = stiff(world, 1e4, 0.5, 0.3);
            dem_sieve_desc s = sieve_of(DEM_SIEVE_REDUCED, 0.01, 0.003);
            dem_cluster_desc cluster = DEM_CLUSTER_DESC;
            dem_body grain;
            double start, most = 0;
            int k;
            s.model = 2;
            s.clearance = DEM_R(0.6);
            dem_wall_sieve_add(world, stuff, &s);
            cluster.count = 2;
            cluster.positions = places;
            cluster.radius = DEM_R(0.003);
            grain = dem_body_add(world, stuff, dem_shape_cluster_add(world, &cluster),
                                 at(0.003 + 0.001*i, 0, 0.01), dem_quat_about(at(0, 1, 0), DEM_R(0.3)));
            start = 9.81*0.01;
            for (k = 0; k < 300; k++) {
                dem_totals t;
                CHECK_EQ(scene_step(world, 50), DEM_OK);
                t = dem_totals_get(world);
                t.kinetic = (t.kinetic + t.rotational)/t.mass +
                    9.81*(double)scene_state(world, grain).position.z;
                most = t.kinetic > most ? t.kinetic : most;
            }
            CHECK(most < start*1.001);
            CHECK(most > 0.5*start || most <= 0);
            dem_world_destroy(world);
        }
    }

    TEST("a sieve's frame is orthonormal for any given directions") {
        static const double rows[6][6] = {{1, 1, 1, 1, 1, 1}, {1, 1, 1, 0.1, 0.1, 0.1 + 1e-15},
            {0, 0, 0, 0, 0, 1}, {1e200, 0, 1e200, 0, 1e-200, 0}, {1e-160, 0, 1e-160, 1e200, 1e200, 0},
            {1, 0, 0, 1, 1e-9, 0}};
        int i, j, k;
        for (i = 0; i < (sizeof(dem_real) > 4 ? 6 : 3); i++) {
            dem_world *world = world_of(0, 1e-5);
            dem_sieve_desc s = sieve_of(DEM_SIEVE_WIRES, 0.01, 0.004);
            dem_pose pose;
            memset(&pose, 0, sizeof pose);
            s.normal = at(rows[i][0], rows[i][1], rows[i][2]);
            s.along = at(rows[i][3], rows[i][4], rows[i][5]);
            CHECK_EQ(dem_wall_pose_get(world, dem_wall_sieve_add(world, stiff(world, 1e4, 0.5, 0), &s), &pose),
                     DEM_OK);
            for (j = 0; j < 3; j++) for (k = 0; k <= j; k++)
                CHECK_NEAR(pose.rotation[j]*pose.rotation[k] + pose.rotation[3 + j]*pose.rotation[3 + k]
                           + pose.rotation[6 + j]*pose.rotation[6 + k], j == k, 1e-6);
            dem_world_destroy(world);
        }
    }

    TEST("a grain that slides along a wire is braked as on a plane, over all crossings") {
        const dem_sieve_desc s = sieve_of(DEM_SIEVE_WIRES, 0.004, 0.002);
        dem_real speed[2];
        int i;
        for (i = 0; i < 2; i++) {
            dem_world *world = world_of(9.81, 2e-5);
            dem_material stuff = stiff(world, 2e4, 0.5, 0.3);
            dem_body grain;
            if (i) dem_wall_sieve_add(world, stuff, &s);
            else dem_wall_plane_add(world, stuff, at(0, 0, 0.001), at(0, 0, 1));
            grain = dem_sphere_add(world, stuff, DEM_R(0.01), at(0.003, 0, 0.01 + 0.001 - 1e-6));
            scene_move(world, grain, at(0, 1, 0), at(0, 0, 0));
            scene_step(world, 5000);             /* 5 cm and more: 15 crossings */
            speed[i] = scene_state(world, grain).velocity.y;
            CHECK((double)scene_state(world, grain).position.y > 0.05);
            CHECK_NEAR(scene_state(world, grain).position.x, 0.003, 1e-7);
            dem_world_destroy(world);
        }
        CHECK_REL(speed[1], (double)speed[0], 2e-3);
    }

    TEST("reduced holes pass ((1 - zeta)(2w - 2r)/(2w + g))^2 of the grains that land, whole, and none too large") {
        static const struct { int model; double zeta, r; } rows[4] = {
            {1, 0.2, 0.004}, {1, 0.8, 0.001}, {2, 0.6, 0.0049}, {2, 0.2, 0.0051}};
        int i, k;
        for (i = 0; i < 4; i++) {
            dem_sieve_desc s = sieve_of(DEM_SIEVE_REDUCED, 0.01, 0.005);
            dem_world *world = world_of(9.81, 2e-5);
            const double w = 0.005, r = rows[i].r;
            dem_material stuff = stiff(world, 1e4*pow(r/0.004, 3), 0.2, 0.5);
            const double side = 2*(1 - rows[i].zeta)*(rows[i].model == 1 ? w - r : w);
            const double p = r < w ? side*side/(0.015*0.015) : 0;
            uint64_t seed = 4;
            int passed = 0, said = 0;
            dem_bodies b;
            s.model = rows[i].model;
            s.clearance = (dem_real)rows[i].zeta;
            dem_wall_sieve_add(world, stuff, &s);
            for (k = 0; k < 900; k++) {
                const double x = 0.030*(k%30) + 0.015*scene_random(&seed);
                const double y = 0.030*(k/30) + 0.015*scene_random(&seed);
                dem_sphere_add(world, stuff, (dem_real)r, at(x, y, r + 0.001));
                said += demi_sieve_passes(&s, at(x, y, 0), (dem_real)r);
            }
            CHECK_EQ(scene_step(world, 4000), DEM_OK);
            b = dem_bodies_get(world);
            for (k = 0; k < b.count; k++) {
                passed += (double)b.positions[4*k + 2] < -r;
                CHECK((double)b.velocities[4*k + 2] > -9.81*0.08*1.01);    /* none was thrown */
            }
            CHECK_EQ(passed, said);
            CHECK_NEAR(passed/900.0, p, 3*sigma(p, 900) + 1e-12);
            dem_world_destroy(world);
        }
    }

    TEST("a grain that moves sideways while it falls through a reduced hole is not caught half way") {
        dem_sieve_desc s = sieve_of(DEM_SIEVE_REDUCED, 0.01, 0.005);
        dem_world *world = world_of(9.81, 2e-5);
        dem_material stuff = stiff(world, 1e4, 0.5, 0);
        dem_body grain;
        s.model = 2;
        dem_wall_sieve_add(world, stuff, &s);
        grain = dem_sphere_add(world, stuff, DEM_R(0.004), at(0, 0, 0.0041));
        scene_move(world, grain, at(0.5, 0, 0), at(0, 0, 0));      /* a pitch in .03 s; 8 mm take .04 */
        CHECK_EQ(scene_step(world, 5000), DEM_OK);
        CHECK_NEAR(scene_state(world, grain).velocity.z, -0.981, 1e-6);
        CHECK_NEAR(scene_state(world, grain).velocity.x, 0.5, 1e-9);
        dem_world_destroy(world);
    }

    TEST("sieves with bad sizes are rejected with the size named") {
        dem_world *world = world_of(0, 0);
        dem_material stuff = stiff(world, 1e4, 0.5, 0.3);
        dem_sieve_desc s = sieve_of(DEM_SIEVE_NONE, 1, 1);
        CHECK_EQ(dem_wall_sieve_add(world, stuff, &s).id, 0);
        CHECK_STR(dem_world_error_get(world), "kind is 0");
        s = sieve_of(DEM_SIEVE_WIRES, 0, 1);
        CHECK_EQ(dem_wall_sieve_add(world, stuff, &s).id, 0);
        CHECK_STR(dem_world_error_get(world), "aperture is 0");
        s = sieve_of(DEM_SIEVE_WIRES, 1, 1);
        s.thickness = 1;
        CHECK_EQ(dem_wall_sieve_add(world, stuff, &s).id, 0);
        CHECK_STR(dem_world_error_get(world), "thickness is 1");
        s = sieve_of(DEM_SIEVE_SLOTS, 1, 1);
        s.length = DEM_R(0.5);
        CHECK_EQ(dem_wall_sieve_add(world, stuff, &s).id, 0);
        CHECK_STR(dem_world_error_get(world), "length is 0.5");
        s = sieve_of(DEM_SIEVE_REDUCED, 1, 1);
        s.clearance = DEM_R(1.5);
        CHECK_EQ(dem_wall_sieve_add(world, stuff, &s).id, 0);
        CHECK_STR(dem_world_error_get(world), "clearance is 1.5");
        CHECK_EQ(dem_sieve_blinded_get(world, dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1)), 0),
                 -1);
        CHECK_STR(dem_world_error_get(world), "not a sieve");
        dem_world_destroy(world);
    }

    return test_end();
}
