/* The small examples and formulas of the texts of docs/seeds.md that no other test has: those of [ALK07] on searches, Verlet
   lists, slices for several processors, sieves, damping and reversibility, those of [MIL] on forces, packings and clusters,
   and claims of [RUB15] and [CRI14] on gases and splitters. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

#define SINGLE (sizeof(dem_real) == sizeof(float))
static const double pi = 3.14159265358979323846;
static const dem_search searches[] = {DEM_SEARCH_ALL_PAIRS, DEM_SEARCH_GRID, DEM_SEARCH_LINKED_LIST, DEM_SEARCH_HIERARCHICAL,
                                      DEM_SEARCH_BINS};
enum { SEARCHES = sizeof searches/sizeof *searches };

/* ---- discs in a plane, numbered from 1 as in the thesis ---- */

typedef struct disc { double x, y, radius; } disc;

static dem_world *discs_make(const disc *d, int count, dem_search search, double skin) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material stuff;
    int i;
    desc.planar = 1;
    desc.search = search;
    desc.skin = (dem_real)skin;
    desc.threads = 1;
    world = dem_world_create(&desc);
    stuff = scene_material(world, 1e7, 0.5, 0.3, 0);
    for (i = 0; i < count; i++) dem_sphere_add(world, stuff, (dem_real)d[i].radius, at(d[i].x, d[i].y, 0));
    CHECK_EQ(dem_candidates_rebuild(world), DEM_OK);
    return world;
}
/* Writes the candidate pairs, such as "1/4 2/3", in rising order. */
static const char *pairs_of(const dem_world *world) {
    static char text[400];
    uint32_t pair[200];
    const int count = dem_candidates_get(world, pair, 100);
    unsigned a, b;
    int i;
    text[0] = 0;
    for (a = 1; a < 20; a++)
        for (b = a + 1; b < 20; b++)
            for (i = 0; i < count; i++)
                if ((pair[2*i] == a && pair[2*i + 1] == b) || (pair[2*i] == b && pair[2*i + 1] == a))
                    sprintf(text + strlen(text), "%s%u/%u", *text ? " " : "", a, b);
    return text;
}
/* Writes the ends of the discs along an axis in rising order, -i where disc i begins and +i where it ends. */
static const char *ends_of(const disc *d, int count, int axis) {
    static char text[2][200];
    char *out = text[axis];
    double last = -1e300;
    int k;
    *out = 0;
    for (k = 0; k < 2*count; k++) {
        double best = 1e300;
        int i, which = 0;
        for (i = 0; i < 2*count; i++) {
            const disc *c = &d[i/2];
            const double end = (axis ? c->y : c->x) + (i%2 ? c->radius : -c->radius);
            if (end > last && end < best) { best = end; which = i%2 ? i/2 + 1 : -(i/2 + 1); }
        }
        last = best;
        sprintf(out + strlen(out), "%s%+d", k ? " " : "", which);
    }
    return out;
}

/* ---- a user-defined law: Hertz's spring and damping by a hysteresis factor ---- */

static double hysteresis_factor;                       /* s/m: mu_h over the stiffness */
static void hysteresis(const dem_contact *c, dem_real *memory, dem_contact_force *push) {
    const double spring = 1e6*pow((double)c->overlap, 1.5);
    (void)memory;
    push->normal = (dem_real)(spring*(1 + hysteresis_factor*(double)c->closing_speed));
}
/* Returns the restitution of two equal balls that collide at this speed (m/s). */
static double hysteresis_restitution(double speed) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material stuff;
    dem_body a;
    double e;
    desc.law = hysteresis;
    desc.law_stiffness = 1e6;
    desc.dt = DEM_R(1e-7);
    desc.threads = 1;
    world = dem_world_create(&desc);
    stuff = scene_material(world, 1e7, 0.5, 0, 0);
    a = dem_sphere_add(world, stuff, DEM_R(0.005), at(-0.0050001, 0, 0));
    scene_move(world, a, at(speed/2, 0, 0), at(0, 0, 0));
    scene_move(world, dem_sphere_add(world, stuff, DEM_R(0.005), at(0.0050001, 0, 0)), at(-speed/2, 0, 0), at(0, 0, 0));
    CHECK_EQ(dem_world_run(world, 4e-3/fmin(speed, 1), 0, 0), DEM_OK);
    e = -2*(double)scene_state(world, a).velocity.x/speed;
    CHECK_EQ(dem_contacts_get(world, 0, 0), 0);        /* the contact has ended */
    dem_world_destroy(world);
    return e;
}
/* The same in closed form. With F = f(delta)(1 + q v), the integrals of m v dv/(1 + q v) over compression and over expansion
   are equal for any f: d - ln(1 + d) = -x - ln(1 - x), d = q v0, x = d times the restitution. */
static double hysteresis_closed(double d) {
    const double left = d - log(1 + d);
    double lo = 0, hi = d < 1 ? d : 1 - 1e-12;
    int i;
    for (i = 0; i < 100; i++) {
        const double x = (lo + hi)/2;
        if (-x - log(1 - x) < left) lo = x;
        else hi = x;
    }
    return lo/d;
}

/* The normal force of [MIL] section 4.1: 2 pi E (R - r/2)^2, r the distance of the centres, without the cubic term. */
static const double first_young = 6.396e10;            /* Pa, glass */
static void first_principles(const dem_contact *c, dem_real *memory, dem_contact_force *push) {
    const double half = (double)c->overlap/2;
    (void)memory;
    push->normal = (dem_real)(2*pi*first_young*half*half);
}

/* ---- a gas that runs forwards and backwards ---- */

/* Runs 64 elastic balls in a periodic box for `steps`, reverses all velocities and runs as many steps again. Returns the
   largest distance of a ball from where it began, over the radius. moved: over the radius, how far a ball went at most;
   collided: contacts of a ball that ended on the way forwards. */
static double there_and_back(dem_integrator integrator, int steps, double *moved, double *collided) {
    const dem_material any = {0};
    dem_impacts impacts;
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material stuff;
    dem_body ball[64];
    dem_vec3 start[64];
    const double radius = 0.01, pitch = 0.03;
    double worst = 0;
    uint64_t random = 7;
    int i, k;
    desc.domain = box_of(0, 0, 0, 4*pitch, 4*pitch, 4*pitch);
    for (i = 0; i < 3; i++) desc.boundary[i] = DEM_BOUNDARY_PERIODIC;
    desc.integrator = integrator;
    desc.dt = DEM_R(2e-6);
    desc.impact_speed = 1;
    desc.ledger = 1;
    desc.threads = 1;
    world = dem_world_create(&desc);
    stuff = scene_material(world, 1e8, 1, 0, 0);
    for (i = 0; i < 64; i++) {
        start[i] = at(pitch*(i%4 + 0.5), pitch*(i/4%4 + 0.5), pitch*(i/16 + 0.5));
        ball[i] = dem_sphere_add(world, stuff, (dem_real)radius, start[i]);
        scene_move(world, ball[i], scene_at(&random, 2, -1, 2, -1, 2, -1), at(0, 0, 0));
    }
    *moved = 0;
    CHECK_EQ(dem_events_record(world, &DEM_EVENTS_DESC), DEM_OK);
    for (k = 0; k < 2; k++) {
        CHECK_EQ(dem_world_step(world, steps), DEM_OK);
        CHECK_EQ(dem_impacts_get(world, any, any, &impacts), DEM_OK);
        if (!k) *collided = 2*impacts.rate*impacts.seconds/64;
        for (i = 0; i < 64; i++) {
            dem_body_state s = scene_state(world, ball[i]);
            double away = 0, x[3];
            int c;
            x[0] = (double)s.position.x - (double)start[i].x;
            x[1] = (double)s.position.y - (double)start[i].y;
            x[2] = (double)s.position.z - (double)start[i].z;
            for (c = 0; c < 3; c++) {
                x[c] -= 4*pitch*floor(x[c]/(4*pitch) + 0.5);
                away += x[c]*x[c];
            }
            if (k) worst = fmax(worst, sqrt(away)/radius);
            else *moved = fmax(*moved, sqrt(away)/radius);
            scene_move(world, ball[i], at(-(double)s.velocity.x, -(double)s.velocity.y, -(double)s.velocity.z), at(0, 0, 0));
        }
    }
    dem_world_destroy(world);
    return worst;
}

/* ---- an elastic gas of ellipsoids ---- */

enum { GAS = 216 };
typedef struct ellipsoids {
    dem_world *world;
    double cube, xi;                                   /* m; aspect ratio */
    double contacts, central, slow;                    /* sums over contacts that have begun */
} ellipsoids;

/* Notes the lever arms of the normal about both centres when a contact begins. */
static void contact_note(const dem_event *event, void *user) {
    ellipsoids *g = (ellipsoids *)user;
    const double b = cbrt(1/g->xi), inertia = (g->xi*g->xi + 1)*b*b/5;   /* of a body of volume 4 pi/3 and mass 1 */
    double nearest = 1e300, sum = 0;
    int k, c;
    if (event->kind != DEM_EVENT_BEGIN) return;
    for (k = 0; k < 2; k++) {
        const dem_vec3 centre = scene_state(g->world, k ? event->b : event->a).position;
        const double n[3] = {(double)event->normal.x, (double)event->normal.y, (double)event->normal.z};
        double x[3], along = 0, length = 0;
        x[0] = (double)event->point.x - (double)centre.x;
        x[1] = (double)event->point.y - (double)centre.y;
        x[2] = (double)event->point.z - (double)centre.z;
        for (c = 0; c < 3; c++) {
            x[c] -= g->cube*floor(x[c]/g->cube + 0.5);
            along += x[c]*n[c];
            length += x[c]*x[c];
        }
        nearest = fmin(nearest, sqrt(fmax(0, length - along*along)));
        sum += fmax(0, length - along*along)/inertia/2;
    }
    g->contacts++;
    g->central += nearest < 0.1;
    g->slow += 1/sqrt(1 + sum);
}
/* 216 ellipsoids with 2000 kg/m3 and k = 1e8 N/m fill 0.058 of a periodic cube, as in [RUB15]. Lengths of every other
   body are `ratio` times as large; the mean volume is that of a sphere of 1 m. Velocities are random, of bodies of one size
   only if `one`; there is no rotation. */
static ellipsoids ellipsoids_make(double xi, double ratio, int one, double restitution, double friction) {
    const double small = cbrt(2/(1 + ratio*ratio*ratio)), b = cbrt(1/xi), mass = 2000*4*pi/3, pitch = cbrt(4*pi/3/0.058);
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc m = DEM_MATERIAL_DESC;
    dem_material stuff;
    dem_shape shape;
    static dem_real x[3*GAS], q[4*GAS], v[3*GAS], scale[GAS];
    double drift[3] = {0, 0, 0}, all = 0;
    uint64_t random = 5;
    ellipsoids g;
    int i, k;
    memset(&g, 0, sizeof g);
    g.xi = xi;
    g.cube = 6*pitch;
    desc.domain = box_of(0, 0, 0, g.cube, g.cube, g.cube);
    for (k = 0; k < 3; k++) desc.boundary[k] = DEM_BOUNDARY_PERIODIC;
    desc.normal_law = DEM_NORMAL_LINEAR;
    desc.dt = (dem_real)(pi*sqrt(mass*small*small*small/2/1e8)/40);
    desc.ledger = 1;
    desc.threads = 1;
    g.world = dem_world_create(&desc);
    m.density = 2000;
    m.stiffness = DEM_R(1e8);
    m.restitution = (dem_real)restitution;
    m.friction = (dem_real)friction;
    stuff = dem_material_add(g.world, &m);
    shape = dem_shape_ellipsoid_add(g.world, at(b, b, xi*b));
    for (i = 0; i < GAS; i++) {
        double four[4], length = 0;
        scale[i] = (dem_real)(i%2 ? small*ratio : small);
        for (k = 0; k < 4; k++) {
            four[k] = scene_random(&random) + scene_random(&random) + scene_random(&random) - 1.5;
            length += four[k]*four[k];
        }
        for (k = 0; k < 4; k++) q[4*i + k] = (dem_real)(four[k]/sqrt(length));
        for (k = 0; k < 3; k++) {
            const int cell = k == 0 ? i%6 : k == 1 ? i/6%6 : i/36;
            const double weight = pow((double)scale[i], 3);
            x[3*i + k] = (dem_real)(pitch*(cell + 0.5));
            v[3*i + k] = (dem_real)(one && i%2 == 0 ? 0 : 12*(scene_random(&random) - 0.5)); /* overlaps of about 0.02 */
            drift[k] += weight*(double)v[3*i + k];
            all += weight/3;
        }
    }
    for (i = 0; i < 3*GAS; i++) v[i] -= (dem_real)(drift[i%3]/all);
    CHECK_EQ(dem_bodies_add(g.world, stuff, shape, GAS, x, q, v, 0, scale), DEM_OK);
    return g;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("velocity Verlet takes an elastic gas back to its start when velocities are reversed") {
        double moved, collided;
        const double back = there_and_back(DEM_INTEGRATOR_VELOCITY_VERLET, 20000, &moved, &collided);
        const double euler = there_and_back(DEM_INTEGRATOR_FORWARD_EULER, 20000, &moved, &collided);
        CHECK(moved > 5 && collided > 1);              /* radii; 2.9 collisions of each ball */
        CHECK_NEAR(back, 0, SINGLE ? 0.1 : 1e-10);     /* round-off, which every collision multiplies: 9e-12 */
        CHECK(euler > 0.1);                            /* 0.93 */
    }

    TEST("damping by the hysteresis factor 3 k (1 - e2)/(4 v) has a higher restitution than e") {
        static const double wanted[4] = {0.9, 0.7, 0.5, 0};
        int i, k;
        for (i = 0; i < 4; i++)
            for (k = 0; k < 3; k++) {
                const double speed = k == 0 ? 0.1 : k == 1 ? 0.5 : 1, d = 0.75*(1 - wanted[i]*wanted[i]);
                hysteresis_factor = d/speed;           /* of the speed of this impact: the same at any speed */
                CHECK_NEAR(hysteresis_restitution(speed), hysteresis_closed(d), SINGLE ? 1e-2 : 1e-4);
                hysteresis_factor = d;                 /* of 1 m/s: falls as the speed grows */
                CHECK_NEAR(hysteresis_restitution(speed), hysteresis_closed(d*speed), SINGLE ? 1e-2 : 1e-4);
            }
        CHECK_NEAR(hysteresis_closed(0.75*(1 - 0.81)), 0.913, 5e-4);
        CHECK_NEAR(hysteresis_closed(0.75*(1 - 0.25)), 0.725, 5e-4);
        CHECK_NEAR(hysteresis_closed(0.75), 0.663, 5e-4);
    }

    TEST("an elastic normal force 2 pi E (R - r/2)2 overlaps by (3 m v2/(pi E))^(1/3)") {
        const double R = 0.0015, mass = 2500*4*pi*R*R*R/3, speed = 1.2, deep = cbrt(3*mass/2*speed*speed/(pi*first_young));
        double c;
        int k;
        for (k = 0; k < 2; k++) {                      /* by this law, and by Hertz's */
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_material_desc m = scene_stuff(first_young, 1, 0, 0);
            dem_world *world;
            dem_material stuff;
            if (!k) desc.law = first_principles;
            if (!k) desc.law_stiffness = (dem_real)(pi*first_young*deep);
            desc.dt = DEM_R(2e-8);
            desc.threads = 1;
            m.poisson = DEM_R(0.23);
            world = dem_world_create(&desc);
            stuff = dem_material_add(world, &m);
            scene_move(world, dem_sphere_add(world, stuff, (dem_real)R, at(-1.00001*R, 0, 0)), at(speed/2, 0, 0), at(0, 0, 0));
            scene_move(world, dem_sphere_add(world, stuff, (dem_real)R, at(1.00001*R, 0, 0)), at(-speed/2, 0, 0), at(0, 0, 0));
            CHECK_EQ(dem_world_step(world, 2000), DEM_OK);
            CHECK_REL((double)dem_counters_get(world).overlap_max*R, k ? 0.00245*R : deep, k ? 0.01 : 2e-3);
            dem_world_destroy(world);
        }
        CHECK_NEAR(deep/R, 0.0048, 5e-5);              /* twice as deep as with Hertz's law */
        for (c = 0.975; c < 1; c += 0.005)             /* the cubic term, for overlaps up to 5 % of R */
            CHECK_NEAR(4*((1 - c*c*c)/3 - c*(1 - c*c)/2)/(2*(1 - c)*(1 - c)), 1, 0.01);
    }

    TEST("five discs with Verlet circles of five radii have five candidate pairs instead of ten") {
        static const disc five[5] = {{-4.5, 0, 1}, {2, 3.5, 1}, {0, 0, 1}, {5.5, 0, 1}, {2.5, -3.5, 1}};
        int k;
        for (k = 0; k < SEARCHES; k++) {
            dem_world *world = discs_make(five, 5, searches[k], 3);      /* 5 r less the two radii */
            CHECK_STR(pairs_of(world), "1/3 2/3 2/4 3/5 4/5");           /* the thesis names those of 1 and 3 */
            CHECK_EQ(strlen(pairs_of(world)), strlen("1/3 2/3 2/4 3/5 4/5"));
            dem_world_destroy(world);
        }
    }

    TEST("boxes of five discs: 1/4 ends, 2/3 stays and 4/5 begins as disc 4 moves") {
        /* places with the orders of ends that the thesis prints for its Fig 2.13 */
        disc five[5] = {{2.09, -0.67, 0.65}, {2.08, 1.17, 0.90}, {2.81, 0.82, 0.38}, {1.29, -0.35, 0.52}, {0, -0.62, 0.48}};
        int k;
        CHECK_STR(ends_of(five, 5, 0), "-5 +5 -4 -2 -1 +4 -3 +1 +2 +3");
        CHECK_STR(ends_of(five, 5, 1), "-1 -5 -4 +5 +1 +4 -2 -3 +3 +2");
        for (k = 0; k < SEARCHES; k++) {
            dem_world *world = discs_make(five, 5, searches[k], -1);     /* no skin: boxes of the discs themselves */
            dem_body fourth = dem_body_id_get(world, 3);
            dem_body_state s = scene_state(world, fourth);
            CHECK_STR(pairs_of(world), "1/4 2/3");
            CHECK_EQ(strlen(pairs_of(world)), 7);
            s.position.x -= DEM_R(0.52);
            CHECK_EQ(dem_body_set(world, fourth, &s), DEM_OK);
            CHECK_EQ(dem_candidates_rebuild(world), DEM_OK);
            CHECK_STR(pairs_of(world), "2/3 4/5");
            CHECK_EQ(strlen(pairs_of(world)), 7);
            dem_world_destroy(world);
        }
        five[3].x -= 0.52;
        CHECK_STR(ends_of(five, 5, 0), "-5 -4 +5 -2 +4 -1 -3 +1 +2 +3");
    }

    TEST("a list with Verlet circles of five radii lasts far longer than 20 steps of 1e-5 s") {
        /* discs of 10, 15 and 20 mm, k = 720 N/m, e = 0.2, in a tank, as in Fig 2.16 */
        static const double radius[3] = {0.010, 0.015, 0.020};
        int candidates[2], rebuilds[2], shortest[2], k;
        for (k = 0; k < 2; k++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_world *world;
            dem_material_desc m = scene_stuff(1e7, 0.2, 0, 0);
            dem_material stuff;
            uint64_t random = 1, start;
            int i, n, began = 0;
            desc.planar = 1;
            desc.thickness = DEM_R(0.002);
            desc.gravity.y = DEM_R(-9.81);
            desc.normal_law = DEM_NORMAL_LINEAR;
            desc.dt = DEM_R(1e-5);
            desc.threads = 1;
            desc.skin = k ? DEM_R(0.06) : 0;           /* 5 r_max less two r_max; chosen */
            m.stiffness = 720;
            world = dem_world_create(&desc);
            stuff = dem_material_add(world, &m);
            dem_wall_cylinder_add(world, stuff, at(0, 0, 0), at(0, 0, 1), DEM_R(0.9), 1);
            for (i = 0; i < 400; i++) {
                const dem_body b = dem_sphere_add(world, stuff, (dem_real)radius[i%12 == 0 ? 2 : i%2],
                                                  at(0.0412*(i%20 - 9.5), 0.0412*(i/20 - 9.5), 0));
                scene_move(world, b, at(0.2*(scene_random(&random) - 0.5), 0, 0), at(0, 0, 0));
            }
            CHECK_EQ(dem_world_step(world, 20), DEM_OK);
            start = dem_counters_get(world).rebuilds;
            for (n = rebuilds[k] = 0, shortest[k] = 40000; n < 2000; n++) {
                const int before = rebuilds[k];
                CHECK_EQ(dem_world_step(world, 20), DEM_OK);
                rebuilds[k] = (int)(dem_counters_get(world).rebuilds - start);
                if (rebuilds[k] == before) continue;
                if (before) shortest[k] = 20*(n - began) < shortest[k] ? 20*(n - began) : shortest[k];
                began = n;
            }
            candidates[k] = dem_counters_get(world).candidates;
            dem_world_destroy(world);
        }
        CHECK(shortest[1] > 400 && 40000/rebuilds[1] > 1000);            /* 1,538 on average, at least 660 */
        CHECK(shortest[0] > 100);                       /* the chosen skin: at least 200 */
        CHECK(candidates[1] > 3*candidates[0]);        /* 4322 and 1278 */
    }

    TEST("ten grains on three slabs: 7, 4 and 8 visit their neighbours and get their forces back") {
        /* Fig 3.12: processors 1, 2 and 3 have the grains 0 3 5, 2 6 7 and 1 4 8 9. There a halo is sent to lower x, here to
           higher x: the scene is its mirror image. Places are ours. */
        static const double x[10] = {0.30, 2.60, 1.95, 0.60, 2.04, 0.96, 1.96, 1.04, 2.03, 2.80};
        static const double y[10] = {0, 0, 0.5, 0, 0.3, 0.2, 0.3, 0.2, 0.5, 0.4};
        static const int home[3] = {4, 3, 3}, visiting[3] = {0, 2, 1};
        dem_world *world[2];
        dem_body grain[2][10];
        dem_slabs_desc slabs_desc = DEM_SLABS_DESC;
        dem_slabs *slabs;
        int i, k;
        for (k = 0; k < 2; k++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_material stuff;
            desc.dt = DEM_R(1e-5);
            desc.threads = 1;
            desc.skin = DEM_R(0.01);
            desc.impact_speed = 1;
            world[k] = dem_world_create(&desc);
            stuff = scene_material(world[k], 1e7, 0.5, 0.3, 0);
            for (i = 0; i < 10; i++) grain[k][i] = dem_sphere_add(world[k], stuff, DEM_R(0.05), at(-x[i], y[i], 0));
        }
        slabs_desc.count = 3;
        slabs_desc.balance = -1;
        slabs = dem_slabs_create(world[1], &slabs_desc);
        CHECK(slabs != 0);
        CHECK_EQ(dem_slabs_step(slabs, 1), DEM_OK);
        for (k = 0; k < 3; k++) {
            dem_slab s;
            CHECK_EQ(dem_slab_get(slabs, k, &s), DEM_OK);
            CHECK_EQ(s.grains, home[k]);
            CHECK_EQ(s.ghosts, visiting[k]);
        }
        CHECK_EQ(dem_slabs_step(slabs, 99), DEM_OK);
        CHECK_EQ(dem_slabs_collect(slabs, world[1]), DEM_OK);
        CHECK_EQ(dem_world_step(world[0], 100), DEM_OK);
        for (i = 0; i < 10; i++) {
            const dem_body_state one = scene_state(world[0], grain[0][i]), dealt = scene_state(world[1], grain[1][i]);
            CHECK_NEAR(dealt.velocity.x, one.velocity.x, SINGLE ? 1e-5 : 1e-14);
            CHECK_NEAR(dealt.velocity.y, one.velocity.y, SINGLE ? 1e-5 : 1e-14);
            /* pairs across the borders repel: 5 and 7, 6 and 4, 2 and 8 */
            CHECK_EQ(fabs((double)one.velocity.x) > 1e-3, i == 2 || (i > 3 && i < 9));
        }
        dem_slabs_destroy(slabs);
        dem_world_destroy(world[0]);
        dem_world_destroy(world[1]);
    }

    TEST("a square sieve has R/(2w + g) + 1 holes along its radius, or one less at the rim") {
        static const double plates[6][3] = {{0.30, 0.01, 0.010}, {0.31, 0.01, 0.010}, {0.25, 0.008, 0.00406}, {0.249, 0.006, 0.00305},
                                            {0.25, 0.004, 0.00203}, {0.1, 0.0123, 0.01}};       /* R, w, g, m */
        int i;
        for (i = 0; i < 6; i++) {
            const double R = plates[i][0], w = plates[i][1], g = plates[i][2], part = fmod(R/(2*w + g), 1);
            const int formula = (int)floor(R/(2*w + g) + 1 + 0.5);
            dem_world *world = dem_world_create(&DEM_WORLD_DESC);
            dem_sieve_desc sieve = DEM_SIEVE_DESC;
            dem_material stuff = scene_material(world, 1e7, 0.5, 0, 0);
            static dem_contact_info touch[4000];
            static char solid[4000];
            int holes = 0, probes = 0, touches, k;
            sieve.kind = DEM_SIEVE_SQUARE;
            sieve.aperture = (dem_real)(2*w);
            sieve.bar = (dem_real)g;
            sieve.radius = (dem_real)R;
            CHECK(dem_wall_sieve_add(world, stuff, &sieve).id != 0);
            /* small balls just above the plane of the sheet touch it, or are in a hole */
            for (; probes*g/10 < R - g/100; probes++)
                dem_sphere_add(world, stuff, (dem_real)(g/100), at(probes*g/10, 0, g/200));
            CHECK_EQ(dem_world_step(world, 1), DEM_OK);
            touches = dem_contacts_get(world, touch, 4000);
            memset(solid, 0, sizeof solid);
            for (k = 0; k < touches; k++) solid[touch[k].a.slot - 1] = 1;
            for (k = 0; k < probes; k++) holes += !solid[k] && (k == 0 || solid[k - 1]);
            CHECK_EQ(holes, formula - (part >= 0.5 && part < (w + g)/(2*w + g)));
            dem_world_destroy(world);
        }
    }

    TEST("cubic and hexagonal packings have the solid fractions 0.52 and 0.74") {
        const double r = 0.5, skin = 0.02;             /* m */
        const double cell[3] = {2*r, 2*sqrt(3.0)*r, 4*sqrt(2.0/3)*r};    /* with 4 spheres of the hexagonal packing */
        double window[2][3];
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_bodies b;
        int i, k, inside = 0, count, neighbours = 0, centres = 0;
        uint32_t *pair;
        desc.skin = (dem_real)skin;
        world = dem_world_create(&desc);
        dem_spheres_pack(world, scene_material(world, 1e7, 0.5, 0, 0), (dem_real)r, 0, dem_region_make(box_of(0, 0, 0, 10, 10, 10)),
                         0);
        CHECK_EQ(dem_candidates_rebuild(world), DEM_OK);
        b = dem_bodies_get(world);
        for (k = 0; k < 3; k++) { window[0][k] = 2.037; window[1][k] = 2.037 + 3*cell[k]; }
        for (i = 0; i < b.count; i++) {
            int in = 1;
            for (k = 0; k < 3; k++) in &= (double)b.positions[4*i + k] >= window[0][k] && (double)b.positions[4*i + k] < window[1][k];
            inside += in;
        }
        count = dem_candidates_get(world, 0, 0);
        pair = (uint32_t *)malloc(2*(size_t)count*sizeof *pair);
        dem_candidates_get(world, pair, count);
        for (i = 0; i < b.count; i++) {                /* neighbours of the spheres in the middle */
            dem_body_state s = scene_state(world, dem_body_id_get(world, i));
            const uint32_t slot = dem_body_id_get(world, i).slot;
            if (hypot(hypot((double)s.position.x - 5, (double)s.position.y - 5), (double)s.position.z - 5) > 2) continue;
            centres++;
            for (k = 0; k < 2*count; k++) neighbours += pair[k] == slot;
        }
        free(pair);
        CHECK_EQ(inside, 4*27);
        CHECK_NEAR(inside*4*pi*r*r*r/3/(27*cell[0]*cell[1]*cell[2]), pi/(3*sqrt(2.0)), 1e-12);
        CHECK_NEAR(pi/(3*sqrt(2.0)), 0.74, 0.005);
        CHECK(centres > 10);
        CHECK_EQ(neighbours, 12*centres);
        dem_world_destroy(world);
        { /* a cubic packing in a periodic box */
            dem_field_desc field;
            dem_field_data data;
            dem_field f;
            dem_material stuff;
            desc = DEM_WORLD_DESC;
            desc.domain = box_of(0, 0, 0, 6, 6, 6);
            for (k = 0; k < 3; k++) desc.boundary[k] = DEM_BOUNDARY_PERIODIC;
            desc.dt = DEM_R(1e-4);
            desc.skin = (dem_real)skin;
            world = dem_world_create(&desc);
            stuff = scene_material(world, 1e6, 0.5, 0, 0);
            for (i = 0; i < 216; i++)
                dem_sphere_add(world, stuff, (dem_real)r, at(i%6 + 0.5, i/6%6 + 0.5, i/36 + 0.5));
            memset(&field, 0, sizeof field);
            field.box = desc.domain;
            field.cells[0] = field.cells[1] = field.cells[2] = 1;
            f = dem_field_add(world, &field);
            CHECK(f.id != 0);
            CHECK_EQ(dem_world_step(world, 3), DEM_OK);
            CHECK_EQ(dem_field_get(world, f, &data), DEM_OK);
            CHECK_NEAR(data.solid[0]/(double)data.samples, pi/6, 1e-6);
            CHECK_NEAR(pi/6, 0.52, 0.005);
            CHECK_EQ(dem_candidates_get(world, 0, 0), 3*216);            /* six neighbours each */
            dem_world_destroy(world);
        }
    }

    TEST("four spheres in a tetrahedron have the moment 1.4 M r2, a solid tetrahedron M R2/20") {
        dem_world *world = dem_world_create(&DEM_WORLD_DESC);
        const double s = 1/sqrt(2.0);                  /* corners of a cube, 2 apart: spheres of radius 1 touch */
        const dem_real corner[12] = {(dem_real)s, (dem_real)s, (dem_real)s, (dem_real)s, (dem_real)-s, (dem_real)-s,
                                     (dem_real)-s, (dem_real)s, (dem_real)-s, (dem_real)-s, (dem_real)-s, (dem_real)s};
        dem_cluster_desc desc = DEM_CLUSTER_DESC;
        dem_shape_info info;
        desc.count = 4;
        desc.positions = corner;
        desc.radius = 1;
        CHECK_EQ(dem_shape_get(world, dem_shape_cluster_add(world, &desc), &info), DEM_OK);
        CHECK_REL(info.inertia.x, 1.4*info.volume, 3e-5);                /* moments per density; the union is integrated by rays */
        CHECK_REL(info.inertia.y, 1.4*info.volume, 3e-5);
        CHECK_REL(info.inertia.z, 1.4*info.volume, 3e-5);
        CHECK_EQ(dem_shape_get(world, dem_shape_polyhedron_add(world, 4, corner), &info), DEM_OK);
        CHECK_REL(info.inertia.x, 4*info.volume/20, 1e-5);               /* edges R = 2 */
        CHECK_REL(info.inertia.y, 4*info.volume/20, 1e-5);
        CHECK_REL(info.inertia.z, 4*info.volume/20, 1e-5);
        dem_world_destroy(world);
    }

    TEST("the shorter ellipsoids are, the more of their collisions are central") {
        /* root: mean sqrt(1 + D) over contacts, by the quadrature of examples/ellipsoids.c. central: collisions in which the
           normal passes one of the centres within a tenth of the radius of the sphere of equal volume, as measured */
        static const struct { double xi, root, central; } cases[4] = {{1.15, 1.01272, 0.71}, {1.5, 1.09441, 0.24},
                                                                           {2, 1.22253, 0.14}, {3, 1.38976, 0.09}};
        double before = 1;
        int k;
        for (k = 0; k < 4; k++) {
            ellipsoids g = ellipsoids_make(cases[k].xi, 1, 0, 1, 0);
            dem_events_desc events = DEM_EVENTS_DESC;
            events.function = contact_note;
            events.user = &g;
            events.begins = 1;
            CHECK_EQ(dem_world_step(g.world, 6000), DEM_OK);             /* bodies begin to rotate */
            CHECK_EQ(dem_events_record(g.world, &events), DEM_OK);
            CHECK_EQ(dem_world_step(g.world, 15000), DEM_OK);
            CHECK(g.contacts > 500);
            CHECK_REL(g.contacts/g.slow, cases[k].root, 0.03);           /* collisions favour a large D by sqrt(1 + D) */
            CHECK_NEAR(g.central/g.contacts, cases[k].central, 0.05);    /* error of the count: 0.012 */
            CHECK(g.central/g.contacts < before);
            before = g.central/g.contacts;
            dem_world_destroy(g.world);
        }
    }

    TEST("a gas of ellipsoids of two sizes, 8 to 1 in mass, keeps its energy and shares it equally") {
        ellipsoids g = ellipsoids_make(1.5, 2, 1, 1, 0);     /* only the large ones move at first */
        const dem_totals start = dem_totals_get(g.world);
        double temperature[2] = {0, 0}, rotation = 0, translation = 0;
        dem_totals end;
        int n, i;
        for (n = 0; n < 400; n++) {
            CHECK_EQ(dem_world_step(g.world, 300), DEM_OK);
            if (n < 200) continue;
            end = dem_totals_get(g.world);
            translation += end.kinetic/(1.5*(GAS - 1));
            rotation += end.rotational/GAS;
            for (i = 0; i < GAS; i++) {
                const dem_bodies b = dem_bodies_get(g.world);
                const dem_real *u = b.velocities + 4*i;
                temperature[b.positions[4*i + 3] > 1] += (double)(b.masses[i]*(u[0]*u[0] + u[1]*u[1] + u[2]*u[2]));
            }
        }
        end = dem_totals_get(g.world);
        CHECK_NEAR((end.kinetic + end.rotational)/start.kinetic, 1, 0.01);
        CHECK_NEAR(temperature[1]/temperature[0], 1, 0.25);                 /* 108 bodies each, some ten independent samples */
        CHECK_NEAR(translation/rotation, 1, 0.2);
        dem_world_destroy(g.world);
    }

    TEST("rough ellipsoids cool faster than smooth ones, and spin about their own axes") {
        double left[2], axial[2];
        int k, i;
        for (k = 0; k < 2; k++) {
            ellipsoids g = ellipsoids_make(2, 1, 0, 0.9, k ? 0.5 : 0);
            const double start = dem_totals_get(g.world).kinetic;
            dem_totals end;
            dem_ledger ledger;
            CHECK_EQ(dem_world_step(g.world, 40000), DEM_OK);
            end = dem_totals_get(g.world);
            ledger = dem_ledger_get(g.world);
            left[k] = (end.kinetic + end.rotational)/start;
            axial[k] = 0;
            for (i = 0; i < GAS; i++) {
                const dem_body_state s = scene_state(g.world, dem_body_id_get(g.world, i));
                axial[k] += pow((double)dem_quat_unrotate(s.orientation, s.spin).z, 2)/GAS;
            }
            CHECK_NEAR(ledger.residual/ledger.throughput, 0, SINGLE ? 1e-2 : 1e-3);
            dem_world_destroy(g.world);
        }
        CHECK_NEAR(axial[0], 0, SINGLE ? 1e-4 : 1e-15);                  /* round-off: no torque about the axis without friction */
        CHECK(axial[1] > 0.5);                         /* (rad/s)^2; 1.6 */
        CHECK(left[1] < 0.4*left[0]);                  /* 0.065 and 0.36 of the energy */
    }

    TEST("a splitter that is a fixed body divides a stream as its position does, except at its edge") {
        /* balls of 1 mm radius fall by their weight onto the upper edge, at y = 0, of an upright plate 1 mm thick; impulses */
        enum { BALLS = 200 };
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material stuff;
        dem_body ball[BALLS], plate;
        dem_body_state s;
        double start[BALLS];
        uint64_t random = 11;
        int i, right = 0, by_position = 0, edge = 0;
        desc.gravity.y = DEM_R(-9.81);
        desc.response = DEM_RESPONSE_IMPULSES;
        desc.dt = DEM_R(1e-4);
        desc.threads = 1;
        world = dem_world_create(&desc);
        stuff = scene_material(world, 1e7, 0.5, 0.3, 0);
        plate = dem_body_add(world, stuff, scene_box(world, 0.001, 0.05, 1), at(0, -0.025, 0), dem_quat_make(1, 0, 0, 0));
        s = scene_state(world, plate);
        s.fixed = 1;
        CHECK_EQ(dem_body_set(world, plate, &s), DEM_OK);
        for (i = 0; i < BALLS; i++) {
            start[i] = 0.02*(scene_random(&random) - 0.5);
            ball[i] = dem_sphere_add(world, stuff, DEM_R(0.001), at(start[i], 0.005, 0.004*(i - BALLS/2)));
        }
        CHECK_EQ(dem_world_step(world, 1000), DEM_OK);
        for (i = 0; i < BALLS; i++) {
            const double x = (double)scene_state(world, ball[i]).position.x;
            right += x > 0;
            by_position += start[i] > 0;
            if (fabs(start[i]) > 0.0015) CHECK_NEAR(x, start[i], SINGLE ? 1e-6 : 1e-12);    /* these do not touch it */
            else {
                edge++;
                CHECK(fabs(x) > 0.0014 || (double)scene_state(world, ball[i]).position.y > 0);
            }
        }
        CHECK(edge > 10 && abs(right - by_position) <= edge/2);           /* 36 balls; 106 on the right either way */
        CHECK_NEAR(scene_state(world, plate).position.y, -0.025, 1e-9);
        dem_world_destroy(world);
    }

    TEST("a mill of 96 triangles on 96 vertices lifts 200 beads as the profile of its 48 segments does") {
        /* [MIL] Fig 5.14: 12 lifters, 120 mm wide and long; the heights of the lifters are ours. End plates are planes */
        enum { AROUND = 48, BEADS = 200 };
        dem_real corners[2*AROUND], vertices[6*AROUND];
        int32_t segments[2*AROUND], triangles[6*AROUND];
        dem_profile profile;
        dem_mesh mesh;
        double apart = 0, work[2], rise[2];
        dem_body bead[2][BEADS];
        dem_world *world[2];
        int i, k, n, by_mesh;
        for (i = 0; i < AROUND; i++) {
            const double angle = 2*pi*(i/4 + 0.08*(i%4))/12, r = i%4 == 1 || i%4 == 2 ? 0.054 : 0.06;
            corners[2*i] = (dem_real)(r*cos(angle));
            corners[2*i + 1] = (dem_real)(r*sin(angle));
            segments[2*i] = i;
            segments[2*i + 1] = (i + 1)%AROUND;
            for (k = 0; k < 2; k++) {
                const int32_t turn[6] = {0, 1, AROUND, 1, AROUND + 1, AROUND};
                dem_real *v = vertices + 3*(AROUND*k + i);
                v[0] = corners[2*i]; v[1] = corners[2*i + 1]; v[2] = DEM_R(0.06)*(dem_real)(2*k - 1);
                for (n = 3*k; n < 3*k + 3; n++)
                    triangles[6*i + n] = turn[n]%AROUND ? (i + 1)%AROUND + turn[n]/AROUND*AROUND : i + turn[n];
            }
        }
        profile.vertex_count = profile.segment_count = AROUND;
        profile.vertices = corners; profile.segments = segments;
        mesh.vertex_count = mesh.triangle_count = 2*AROUND;
        mesh.vertices = vertices; mesh.triangles = triangles;
        for (by_mesh = 0; by_mesh < 2; by_mesh++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_motion turn = DEM_MOTION;
            dem_material stuff;
            dem_wall shell;
            dem_wall_loads loads;
            uint64_t random = 3;
            desc.gravity.y = DEM_R(-9.81);
            desc.dt = DEM_R(2e-5);
            desc.threads = 1;
            world[by_mesh] = dem_world_create(&desc);
            stuff = scene_material(world[by_mesh], 1e6, 0.5, 0.3, 0);
            dem_wall_plane_add(world[by_mesh], stuff, at(0, 0, -0.06), at(0, 0, 1));
            dem_wall_plane_add(world[by_mesh], stuff, at(0, 0, 0.06), at(0, 0, -1));
            shell = by_mesh ? dem_wall_mesh_add(world[by_mesh], stuff, &mesh)
                : dem_wall_profile_add(world[by_mesh], stuff, &profile, DEM_EDGE_RESOLVED);
            CHECK(shell.id > 0);
            turn.kind = DEM_MOTION_ROTATING;
            turn.axis = at(0, 0, 1);
            turn.speed = 8;
            CHECK_EQ(dem_wall_motion_set(world[by_mesh], shell, &turn), DEM_OK);
            rise[by_mesh] = 0;
            for (i = 0; i < BEADS; i++)                              /* a block of 5 x 4 x 10 in the lower half */
                bead[by_mesh][i] = dem_sphere_add(world[by_mesh], stuff, DEM_R(0.004), at(
                    -0.018 + 0.009*(i%5) + 1e-4*scene_random(&random), -0.042 + 0.009*(i/5%4), -0.045 + 0.01*(i/20)));
            CHECK_EQ(dem_world_step(world[by_mesh], 10000), DEM_OK);
            CHECK_EQ(dem_wall_loads_get(world[by_mesh], shell, &loads), DEM_OK);
            work[by_mesh] = loads.work;
            for (i = 0; i < BEADS; i++) rise[by_mesh] += (double)scene_state(world[by_mesh], bead[by_mesh][i]).position.x/BEADS;
        }
        for (i = 0; i < BEADS; i++) {
            const dem_vec3 a = scene_state(world[0], bead[0][i]).position, b = scene_state(world[1], bead[1][i]).position;
            apart = fmax(apart, fabs((double)(a.x - b.x)) + fabs((double)(a.y - b.y)) + fabs((double)(a.z - b.z)));
        }
        CHECK(apart < (SINGLE ? 1e-2 : 1e-8));                       /* 2e-11 after 10,000 steps */
        CHECK_REL(work[1], work[0], SINGLE ? 0.05 : 1e-6);
        CHECK(work[0] > 0.03 && rise[0] > 0.02);                     /* J; m, towards the side that goes up */
        dem_world_destroy(world[0]);
        dem_world_destroy(world[1]);
    }

    return test_end();
}
