/* Neighbour search: all pairs, grid, linked linear list, levels and bins against a brute-force oracle of
   their own. The oracle looks at every pair of bodies with the shortest image, in double precision,
   and knows nothing of cells, sorting or skins. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

enum { METHODS = 5, MOST = 900 };
static const dem_search methods[METHODS] = {DEM_SEARCH_ALL_PAIRS, DEM_SEARCH_GRID,
                                            DEM_SEARCH_LINKED_LIST, DEM_SEARCH_HIERARCHICAL, DEM_SEARCH_BINS};
static uint32_t listed[MOST][MOST], mark;      /* pairs of slots seen under the present mark */
static uint32_t pairs[2*MOST*(MOST - 1)/2];

static double gap_of(const dem_world_desc *desc, const dem_real *x, const dem_real *y) {
    const double lo[3] = {(double)desc->domain.lo.x, (double)desc->domain.lo.y,
                          (double)desc->domain.lo.z};
    const double hi[3] = {(double)desc->domain.hi.x, (double)desc->domain.hi.y,
                          (double)desc->domain.hi.z};
    double square = 0;
    int k;
    for (k = 0; k < 3; k++) {
        double d = (double)y[k] - (double)x[k];
        if (desc->boundary[k] == DEM_BOUNDARY_PERIODIC)
            d -= (hi[k] - lo[k])*floor(d/(hi[k] - lo[k]) + 0.5);
        square += d*d;
    }
    return sqrt(square) - (double)x[3] - (double)y[3];
}

/* Holds the candidate list against the oracle. Answers how many pairs are wrong: touching and not
   listed, listed twice, or, when the list is fresh, within the skin and not listed or listed and
   beyond it. *contacts: how many touch. Round-off decides pairs within `slack` of a limit. */
static int wrong_pairs(const dem_world *world, const dem_world_desc *desc, int fresh,
                       int *contacts) {
    /* m; positions are < .2 m */
    const double slack = 1e-12, skin = (double)dem_counters_get(world).skin;
    const dem_bodies b = dem_bodies_get(world);
    const int n = dem_candidates_get(world, pairs, MOST*(MOST - 1)/2);
    int i, j, wrong = 0;
    mark++;
    for (i = 0; i < n; i++) {
        const uint32_t lo = pairs[2*i] < pairs[2*i + 1] ? pairs[2*i] : pairs[2*i + 1];
        const uint32_t hi = pairs[2*i] < pairs[2*i + 1] ? pairs[2*i + 1] : pairs[2*i];
        wrong += listed[lo - 1][hi - 1] == mark;
        listed[lo - 1][hi - 1] = mark;
    }
    *contacts = 0;
    for (i = 0; i < b.count; i++)
        for (j = i + 1; j < b.count; j++) {
            const uint32_t s = b.slots[i], t = b.slots[j];
            const int in = listed[s < t ? s : t][s < t ? t : s] == mark;
            const double gap = gap_of(desc, b.positions + 4*i, b.positions + 4*j);
            *contacts += gap < 0;
            if (gap < -slack) wrong += !in;
            if (fresh && gap < skin - slack) wrong += !in;
            if (fresh && gap > skin + slack) wrong += in;
        }
    return wrong;
}

typedef struct churn {
    int periodic[3], planar;
    double skin, length;
    int count, steps;
} churn;

static dem_world *churn_world(const churn *c, dem_search method, dem_world_desc *desc) {
    dem_world *world;
    dem_material grain;
    int k;
    *desc = DEM_WORLD_DESC;
    desc->threads = 1;
    desc->dt = DEM_R(5e-6);
    desc->allow_large_dt = 1;                  /* bits are compared, not physics */
    desc->thickness = DEM_R(2e-3);
    desc->search = method;
    desc->skin = (dem_real)c->skin;
    desc->planar = c->planar;
    desc->domain = box_of(0, 0, 0, c->length, c->length, c->length);
    for (k = 0; k < 3; k++)
        desc->boundary[k] = c->periodic[k] ? DEM_BOUNDARY_PERIODIC : DEM_BOUNDARY_OPEN;
    world = dem_world_create(desc);
    grain = scene_material(world, 1e7, 1, 0.3, 0);
    for (k = 0; k < 3; k++) {
        const double e[3] = {k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0};
        const double l = c->length;
        if (c->periodic[k] || (c->planar && k == 2)) continue;
        dem_wall_plane_add(world, grain, at(0, 0, 0), at(e[0], e[1], e[2]));
        dem_wall_plane_add(world, grain, at(l*e[0], l*e[1], l*e[2]), at(-e[0], -e[1], -e[2]));
    }
    return world;
}
/* Adds up to `count` grains of radii 1 to 10 mm where there is room (by the oracle), mostly small
   ones, with a speed of up to 2 m/s along each axis. All worlds are alike, so one place serves them
   all. */
static int churn_add(dem_world **world, const dem_world_desc *desc, const churn *c, int count,
                     uint64_t *seed) {
    int added = 0, tries, i, m;
    for (tries = 0; tries < 4000 && added < count; tries++) {
        const dem_bodies b = dem_bodies_get(world[0]);
        const double u = scene_random(seed), r = 1e-3 + 9e-3*u*u*u;
        dem_real x[4], v[3];
        dem_material grain;
        int room = 1, k;
        for (k = 0; k < 3; k++) {
            x[k] = (dem_real)(r + (c->length - 2*r)*scene_random(seed));
            v[k] = (dem_real)(4*scene_random(seed) - 2);
        }
        if (c->planar) x[2] = v[2] = 0;
        x[3] = (dem_real)r;
        for (i = 0; i < b.count && room; i++) room = gap_of(desc, x, b.positions + 4*i) > 0;
        if (!room) continue;
        grain.id = 1;
        for (m = 0; m < METHODS; m++) dem_spheres_add(world[m], grain, 1, x, v, 0, (dem_real)r);
        added++;
    }
    return added;
}
/* Rebuilds every list now and holds it against the oracle. */
static int churn_look(dem_world **world, const dem_world_desc *desc, uint64_t *rebuilds) {
    int m, contacts, wrong = 0;
    for (m = 0; m < METHODS; m++) {
        CHECK_EQ(dem_candidates_rebuild(world[m]), DEM_OK);
        wrong += wrong_pairs(world[m], &desc[m], 1, &contacts);
        rebuilds[m] = dem_counters_get(world[m]).rebuilds;
    }
    return wrong;
}
/* Takes out a random body, the same of all worlds. */
static void churn_remove(dem_world **world, uint64_t *seed) {
    const dem_bodies b = dem_bodies_get(world[0]);
    const dem_body body = dem_body_id_get(world[0], (int)(scene_random(seed)*b.count));
    int m;
    for (m = 0; m < METHODS; m++) CHECK_EQ(dem_body_remove(world[m], body), DEM_OK);
}

static void churn_run(churn c, uint64_t seed) {
    dem_world *world[METHODS];
    dem_world_desc desc[METHODS];
    uint64_t rebuilds[METHODS] = {0, 0, 0, 0};
    int step, m, k, wrong = 0, miscounted = 0, apart = 0, fresh_lists = 0, touched = 0;
    for (m = 0; m < METHODS; m++) world[m] = churn_world(&c, methods[m], &desc[m]);
    CHECK(churn_add(world, &desc[0], &c, c.count, &seed) > c.count/2);
    wrong += churn_look(world, desc, rebuilds);
    for (step = 1; step <= c.steps && wrong + miscounted + apart == 0; step++) {
        int contacts = 0;
        for (m = 0; m < METHODS; m++) {
            dem_counters now;
            int fresh;
            if (scene_step(world[m], 1) != DEM_OK) { CHECK(!"the step failed"); step = c.steps;
                break; }
            now = dem_counters_get(world[m]);
            fresh = now.rebuilds != rebuilds[m];
            rebuilds[m] = now.rebuilds;
            fresh_lists += fresh;
            /* the oracle is slow: every list when fresh, one a step otherwise */
            if (fresh || step%METHODS == m) {
                wrong += wrong_pairs(world[m], &desc[m], fresh, &contacts);
                miscounted += now.contacts != contacts;
            }
            if (m && step%5 == 0) apart += dem_world_hash_get(world[m]) != dem_world_hash_get(world[0]);
        }
        touched += contacts;
        if (step%(c.steps/8) == c.steps/16) { /* as many in as out, then more in, then more out */
            const int phase = step/(c.steps/8), out = phase%3 == 1 ? 2 : 6;
            for (k = 0; k < out; k++) churn_remove(world, &seed);
            churn_add(world, &desc[0], &c, phase%3 == 2 ? 1 : 6, &seed);
            wrong += churn_look(world, desc, rebuilds);
        }
    }
    CHECK_EQ(wrong, 0);
    CHECK_EQ(miscounted, 0);
    CHECK_EQ(apart, 0);
    CHECK(touched > c.steps);                   /* it churns: more than one contact a step */
    CHECK(fresh_lists > METHODS);
    for (m = 0; m < METHODS; m++) dem_world_destroy(world[m]);
}
static void churn_skins(int x, int y, int z, int planar) {
    churn c = {{0, 0, 0}, 0, 0, 0.08, 200, 0};
    c.periodic[0] = x; c.periodic[1] = y; c.periodic[2] = z;
    c.planar = planar;
    if (planar) c.length = 0.2;
    c.skin = -1; c.steps = 96;
    churn_run(c, 1);
    c.skin = 0; c.steps = 960;
    churn_run(c, 2);
    c.skin = 2e-3; c.steps = 960;
    churn_run(c, 3);
}

/* Random places for bodies whose radii span 1 : ratio, about half of the box filled, overlaps and
   all: for looking, not for stepping. share: volume of the large ones over that of all; below 0:
   radii all the way between. */
typedef struct mix { double ratio, share; int count, periodic, planar, threads; } mix;
static dem_world *mix_world(const mix *x, dem_search method) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material grain;
    dem_real *place = (dem_real *)malloc((size_t)x->count*4*sizeof(dem_real));
    dem_real *r = place + 3*x->count;
    uint64_t seed = 17;
    double room = 0, side, least;
    const double large = pow(x->ratio, x->planar ? 2 : 3);
    int i, k, big;
    /* how many large ones have that share of the volume, one at least */
    big = x->share > 0 ? (int)(x->count*x->share/(1 - x->share)/large + 1) : 0;
    for (i = 0; i < x->count; i++) {
        double radius = 1e-3;
        if (x->share < 0) radius *= pow(x->ratio, pow(scene_random(&seed), 4));
        if (i%(x->count/(big + 1) + 1) == 1 && big) radius *= x->ratio;
        r[i] = (dem_real)radius;
        room += pow(radius, x->planar ? 2 : 3)*(x->planar ? 3.14 : 4.19);
    }
    side = pow(2*room, x->planar ? 1.0/2 : 1.0/3);
    least = 4.5e-3*x->ratio;                    /* two of the largest and the skin, twice */
    if (x->periodic && side < least) side = least;
    desc.threads = x->threads;
    desc.planar = x->planar;
    desc.search = method;
    desc.skin = DEM_R(2e-4);
    desc.domain = box_of(0, 0, 0, side, side, side);
    for (k = 0; k < 3; k++) if (x->periodic >> k & 1) desc.boundary[k] = DEM_BOUNDARY_PERIODIC;
    world = dem_world_create(&desc);
    grain = scene_material(world, 1e7, 1, 0.3, 0);
    for (i = 0; i < 3*x->count; i++)
        place[i] = (dem_real)(x->planar && i%3 == 2 ? 0 : side*scene_random(&seed));
    CHECK_EQ(dem_spheres_add(world, grain, x->count, place, 0, r, 0), DEM_OK);
    free(place);
    CHECK_EQ(dem_candidates_rebuild(world), DEM_OK);
    return world;
}
/* Do two worlds have the same candidates, in the same order? */
static int mix_same(const dem_world *a, const dem_world *b) {
    const int n = dem_candidates_get(a, 0, 0), m = dem_candidates_get(b, 0, 0);
    uint32_t *p = (uint32_t *)malloc((size_t)n*4*sizeof *p + 1), *q = p + 2*n;
    int same = n == m && n > 100;
    if (same) {
        dem_candidates_get(a, p, n);
        dem_candidates_get(b, q, n);
        same = memcmp(p, q, (size_t)n*2*sizeof *p) == 0;
    }
    free(p);
    return same && dem_world_hash_get(a) == dem_world_hash_get(b);
}
static void mix_compare(mix x, int levels) {
    dem_world *right, *world;
    int m;
    x.threads = 1;
    right = mix_world(&x, DEM_SEARCH_ALL_PAIRS);
    for (m = 1; m < METHODS; m++) {
        x.threads = 1 + m%2;
        world = mix_world(&x, methods[m]);
        CHECK(mix_same(right, world));
        if (methods[m] == DEM_SEARCH_HIERARCHICAL) CHECK(world->levels.count >= levels);
        dem_world_destroy(world);
    }
    dem_world_destroy(right);
}
static dem_search mix_chosen(double ratio, double share) {
    mix x = {1, 0, 3000, 0, 0, 1};
    dem_world *world;
    dem_search chosen;
    char text[4000];
    FILE *out = tmpfile();
    x.ratio = ratio;
    x.share = share;
    world = mix_world(&x, DEM_SEARCH_AUTO);
    chosen = dem_counters_get(world).search;
    if (out) {
        size_t n;
        dem_world_report(world, out);
        rewind(out);
        n = fread(text, 1, sizeof text - 1, out);
        text[n] = 0;
        CHECK_STR(text, chosen == DEM_SEARCH_HIERARCHICAL ? "hierarchical grid"
                  : "uniform grid");
        if (chosen == DEM_SEARCH_HIERARCHICAL) CHECK_STR(text, "levels for radii 1 : ");
        if (ratio > 2.5) CHECK_STR(text, chosen == DEM_SEARCH_HIERARCHICAL ? "chosen: hierarchical grid; distance tests"
                                   : "chosen: uniform grid; distance tests");
        fclose(out);
    }
    dem_world_destroy(world);
    return chosen;
}

/* A drag that stops everything within the step after `start`. */
typedef struct brake { double start, dt; } brake;
static dem_vec3 brake_force(dem_vec3 x, dem_vec3 v, dem_real radius, dem_real mass, double time,
                            void *user) {
    const brake *b = (const brake *)user;
    const double s = time >= b->start ? -(double)mass/b->dt : 0;
    (void)x; (void)radius;
    return at(s*(double)v.x, s*(double)v.y, s*(double)v.z);
}

/* Two balls fly at each other while something acts on bodies at every step, so that none is isolated: gravity, the
   only rail, a cell that deforms, or the only joint. It ends shortly before or at their contact. Returns the speed of
   the left ball soon afterwards, m/s. */
enum { GRAVITY, GRAVITY_IMPULSES, RAIL, CELL, JOINT, ENDINGS };
static double speed_after(int what, double skin) {
    const int impulses = what == GRAVITY_IMPULSES || what == JOINT;
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_rail_desc rail = DEM_RAIL_DESC;
    dem_cell_desc cell = DEM_CELL_DESC, still = DEM_CELL_DESC;
    dem_joint_desc hinge = DEM_JOINT_DESC;
    dem_joint joint;
    dem_world *w;
    dem_material m;
    dem_body a, c, d;
    dem_ledger l;
    double speed;
    int k;
    desc.threads = 1;
    desc.ledger = 1;
    desc.orientations = impulses;
    desc.skin = (dem_real)skin;
    desc.dt = impulses ? DEM_R(1e-3) : DEM_R(2e-6);
    if (impulses) desc.response = DEM_RESPONSE_IMPULSES;
    if (what == GRAVITY || what == GRAVITY_IMPULSES) desc.gravity = at(0, 0, -1e-9);
    desc.domain = box_of(-0.1, -0.1, -0.1, 0.1, 0.1, 0.1);
    for (k = 0; k < 3 && what == CELL; k++) desc.boundary[k] = DEM_BOUNDARY_PERIODIC;
    w = dem_world_create(&desc);
    m = scene_material(w, 1e7, 0.7, 0.3, 0);
    a = dem_sphere_add(w, m, DEM_R(0.01), at(0, 0, 0));
    dem_sphere_add(w, m, DEM_R(0.01), at(impulses ? 0.021 : 0.0202, 0, 0));
    c = dem_sphere_add(w, m, DEM_R(0.01), at(0, 0.06, 0));
    d = dem_sphere_add(w, m, DEM_R(0.01), at(0.03, 0.06, 0));
    scene_move(w, a, at(impulses ? 0.05 : 1, 0, 0), at(0, 0, 0));
    rail.axes = DEM_RAIL_ALL;
    cell.rate = at(1e-6, 0, 0);
    hinge.kind = DEM_JOINT_POINT;
    hinge.a = c;
    hinge.b = d;
    hinge.point = at(0.015, 0.06, 0);
    joint.id = 0;
    if (what == RAIL) CHECK_EQ(dem_body_rail_set(w, c, &rail), DEM_OK);
    if (what == CELL) CHECK_EQ(dem_cell_set(w, &cell), DEM_OK);
    if (what == JOINT) CHECK((joint = dem_joint_add(w, &hinge)).id);
    CHECK_EQ(scene_step(w, impulses ? 18 : 200), DEM_OK);
    rail.axes = 0;
    if (what == GRAVITY || what == GRAVITY_IMPULSES) CHECK_EQ(dem_world_gravity_set(w, at(0, 0, 0)), DEM_OK);
    if (what == RAIL) CHECK_EQ(dem_body_rail_set(w, c, &rail), DEM_OK);
    if (what == CELL) CHECK_EQ(dem_cell_set(w, &still), DEM_OK);
    if (what == JOINT) CHECK_EQ(dem_joint_remove(w, joint), DEM_OK);
    CHECK_EQ(scene_step(w, impulses ? 60 : 15), DEM_OK);
    speed = (double)scene_state(w, a).velocity.x;
    l = dem_ledger_get(w);
    CHECK(fabs(l.residual) < 1e-3*l.throughput);
    dem_world_destroy(w);
    return speed;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("every search gives one list and one hash in a closed box, for every skin") {
        churn_skins(0, 0, 0, 0);
    }
    TEST("every search gives one list and one hash with three periodic axes") {
        churn_skins(1, 1, 1, 0);
    }
    TEST("every search gives one list and one hash for discs in a plane") {
        churn_skins(0, 0, 0, 1);
        churn_skins(1, 0, 0, 1);
    }
    TEST("when one grain leaves and one enters, the linked list forgets the former") {
        churn c = {{0, 0, 0}, 0, 1e-3, 0.08, 60, 0};
        dem_world *world[METHODS];
        dem_world_desc desc[METHODS];
        uint64_t seed = 9;
        uint64_t rebuilds[METHODS];
        int m, round, wrong = 0;
        for (m = 0; m < METHODS; m++) world[m] = churn_world(&c, methods[m], &desc[m]);
        churn_add(world, &desc[0], &c, c.count, &seed);
        for (round = 0; round < 40; round++) {
            for (m = 0; m < METHODS; m++) scene_step(world[m], 3);
            churn_remove(world, &seed);
            churn_add(world, &desc[0], &c, 1, &seed);
            wrong += churn_look(world, desc, rebuilds);
        }
        CHECK_EQ(wrong, 0);
        for (m = 0; m < METHODS; m++) dem_world_destroy(world[m]);
    }
    TEST("radii 1:100 in one world: every search lists what brute force finds") {
        churn c = {{0, 0, 0}, 0, 1e-4, 0.1, 0, 0};
        int periodic, m;
        for (periodic = 0; periodic < 2; periodic++) {
            dem_world *world[METHODS];
            dem_world_desc desc[METHODS];
            dem_material grain;
            uint64_t seed = 4;
            int i, contacts, count[METHODS];
            grain.id = 1;
            c.periodic[0] = c.periodic[1] = periodic;
            for (m = 0; m < METHODS; m++) {
                world[m] = churn_world(&c, methods[m], &desc[m]);
                dem_sphere_add(world[m], grain, DEM_R(0.02), at(0.05, 0.05, 0.05));
                /* over a corner */
                dem_sphere_add(world[m], grain, DEM_R(0.02), at(0.0, 0.0, 0.05));
            }
            for (i = 0; i < 400; i++) {         /* dust on and around the big ones */
                const double u = 2*scene_random(&seed) - 1, phi = 6.28*scene_random(&seed);
                const double d = 0.02 + 4e-4*scene_random(&seed), s = sqrt(1 - u*u), c0 =
                    i%2 ? 0.05 : 0;
                double x = c0 + d*s*cos(phi), y = c0 + d*s*sin(phi);
                if (periodic) { x += x < 0 ? 0.1 : 0; y += y < 0 ? 0.1 : 0; }
                for (m = 0; m < METHODS; m++)
                    dem_sphere_add(world[m], grain, DEM_R(2e-4), at(x, y, 0.05 + d*u));
            }
            for (m = 0; m < METHODS; m++) {
                CHECK_EQ(dem_candidates_rebuild(world[m]), DEM_OK);
                CHECK_EQ(wrong_pairs(world[m], &desc[m], 1, &contacts), 0);
                count[m] = dem_candidates_get(world[m], 0, 0);
                CHECK_EQ(count[m], count[0]);
                CHECK_EQ(dem_world_hash_get(world[m]), dem_world_hash_get(world[0]));
                CHECK(contacts > 100);
            }
            for (m = 0; m < METHODS; m++) dem_world_destroy(world[m]);
        }
    }
    TEST("mixtures of 1:10 and 1:100, periodic or not, 2D and 3D: every search gives the brute-force list, entry by "
         "entry") {
        static const mix all[] = {
            {10, 0.5, 2600, 0, 0, 1}, {10, 0.5, 2600, 1, 0, 1}, {10, 0.5, 2600, 6, 0, 1},
            {10, 0.5, 2600, 7, 0, 1}, {10, 0.3, 2600, 0, 1, 1}, {10, 0.3, 2600, 3, 1, 1},
            {100, 0.99, 2600, 0, 0, 1}, {100, 0.9, 2600, 5, 0, 1}, {100, 0.9, 2600, 7, 0, 1},
            {100, 0.6, 2600, 0, 1, 1}, {100, 0.6, 2600, 2, 1, 1},
            {10, -1, 2600, 0, 0, 1}, {10, -1, 2600, 7, 0, 1}, {100, -1, 2600, 0, 0, 1},
            {100, -1, 2600, 3, 0, 1}, {30, -1, 2600, 0, 1, 1}, {30, -1, 2600, 1, 1, 1},
            {2, 0.5, 3000, 0, 0, 1}, {1, 0, 3000, 7, 0, 1}};
        size_t i;
        for (i = 0; i < sizeof all/sizeof *all; i++)
            mix_compare(all[i], all[i].ratio < 3 ? 1 : all[i].share < 0 && !all[i].planar ? 3 : 2);
    }
    TEST("the hierarchical grid gives one list for any number of threads") {
        mix x = {30, -1, 20000, 3, 0, 1};
        dem_world *one = mix_world(&x, DEM_SEARCH_HIERARCHICAL), *other;
        CHECK(dem_counters_get(one).domains > 4);
        for (x.threads = 2; x.threads <= 8; x.threads++) {
            other = mix_world(&x, DEM_SEARCH_HIERARCHICAL);
            CHECK(mix_same(one, other));
            dem_world_destroy(other);
        }
        dem_world_destroy(one);
    }
    TEST("the library chooses the hierarchical grid for mixtures of 1:10 and 1:100, a uniform grid to 1:2, and "
         "reports it") {
        CHECK_EQ(mix_chosen(10, 0.5), DEM_SEARCH_HIERARCHICAL);
        CHECK_EQ(mix_chosen(10, 0.1), DEM_SEARCH_HIERARCHICAL);
        CHECK_EQ(mix_chosen(100, 0.9), DEM_SEARCH_HIERARCHICAL);
        CHECK_EQ(mix_chosen(100, -1), DEM_SEARCH_HIERARCHICAL);
        CHECK_EQ(mix_chosen(1, 0), DEM_SEARCH_GRID);
        CHECK_EQ(mix_chosen(2, 0.5), DEM_SEARCH_GRID);
        CHECK_EQ(mix_chosen(2, 0.01), DEM_SEARCH_GRID);
    }
    TEST("two swarms a kilometre apart are searched without a grid over the void") {
        churn c = {{0, 0, 0}, 0, 1e-3, 0.08, 0, 0};
        dem_world_desc desc;
        int m, i, contacts;
        for (m = 0; m < METHODS; m++) {
            dem_world *world = dem_world_create(&DEM_WORLD_DESC);
            dem_material grain = scene_material(world, 1e6, 1, 0.3, 0);
            uint64_t seed = 5;
            dem_world_destroy(world);
            world = churn_world(&c, methods[m], &desc);
            grain.id = 1;
            for (i = 0; i < 200; i++)
                dem_sphere_add(world, grain, DEM_R(2e-3), at(i%2*1000 + 0.04*scene_random(&seed),
                               0.04*scene_random(&seed), 0.04*scene_random(&seed)));
            CHECK_EQ(dem_candidates_rebuild(world), DEM_OK);
            CHECK_EQ(wrong_pairs(world, &desc, 0, &contacts), 0);
            CHECK(contacts > 20);
            CHECK(dem_counters_get(world).memory < 4000000);
            dem_world_destroy(world);
        }
    }
    TEST("the lifetime of a pruned neighbour list changes no bit: rebuilt every step or when due") {
        int integrator, late, k;
        for (integrator = DEM_INTEGRATOR_VELOCITY_VERLET; integrator <= DEM_INTEGRATOR_LEAPFROG; integrator++) {
            uint64_t hash[2], makes[2] = {0, 0};
            for (late = 0; late < 2; late++) {
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_world *world;
                uint64_t contacts = 0;
                desc.integrator = (dem_integrator)integrator;
                desc.dt = DEM_R(1e-6);
                desc.skin = DEM_R(2e-4);       /* searches come at the same steps */
                world = dem_world_create(&desc);
                scene_block(world, scene_material(world, 1e7, 0.7, 0.4, 0), 6, 6, 6, 1e-3, 1,
                            0.3, 7);
                for (k = 0; k < 1500; k++) {
                    if (!late) world->margin.span = 0;
                    CHECK_EQ(scene_step(world, 1), DEM_OK);
                    makes[late] += world->margin.age <= 0;
                    contacts += (uint64_t)dem_counters_get(world).contacts;
                }
                CHECK(contacts > 50000);
                hash[late] = dem_world_hash_get(world);
                dem_world_destroy(world);
            }
            CHECK(makes[0] > 3*makes[1]);
            CHECK_EQ(hash[0], hash[1]);
        }
    }
    TEST("in tumbling clusters every near member sphere is listed in time, for lists rebuilt every step or when due") {
        uint64_t hash[2], makes[2] = {0, 0};
        int late, k, i, d, few_near = 0, many_near = 0, contacts = 0, response, listed = 0;
        for (response = 0; response < 2; response++)
        for (late = 0; late < 2; late++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_cluster_desc c = DEM_CLUSTER_DESC;
            dem_real few[24], many[270];
            dem_shape shapes[3] = {{0}, {0}, {0}};
            dem_world *world;
            dem_material stuff;
            uint64_t seed = 11;
            desc.dt = DEM_R(2e-6);
            desc.response = response ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS;
            if (response) desc.law_range = DEM_R(1.5e-4);   /* a tenth of a radius: many pairs of spheres are near */
            desc.skin = DEM_R(3e-4);
            for (k = 0; k < 3; k++) desc.boundary[k] = DEM_BOUNDARY_PERIODIC;
            desc.domain = dem_box_make(0, 0, 0, DEM_R(0.016), DEM_R(0.016), DEM_R(0.016));
            world = dem_world_create(&desc);
            stuff = scene_material(world, 1e7, 0.9, 0.3, 0);
            for (i = 0; i < 24; i++) few[i] = i/3 >> i%3 & 1 ? DEM_R(4.5e-4) : DEM_R(-4.5e-4);
            for (i = 0; i < 270; i++) many[i] = (dem_real)(8e-4*scene_random(&seed) - 4e-4);
            c.mass = DEM_CLUSTER_SUM;
            c.radius = DEM_R(5e-4);
            c.count = 8;
            c.positions = few;
            shapes[1] = dem_shape_cluster_add(world, &c);
            c.count = 90;
            c.positions = many;
            shapes[2] = dem_shape_cluster_add(world, &c);
            for (i = 0; i < 216; i++) {
                const dem_vec3 place = demi_scale(at(i%6, i/6%6, i/36), DEM_R(2.6e-3));
                const dem_body b = i%3 ? dem_body_add(world, stuff, shapes[i%3], place, scene_turn(&seed))
                    : dem_sphere_add(world, stuff, DEM_R(1e-3), place);
                const dem_vec3 v = scene_at(&seed, 2, -1, 2, -1, 2, -1), spin = scene_at(&seed, 2, -1, 2, -1, 2, -1);
                scene_move(world, b, v, demi_scale(spin, 2000));
            }
            for (k = 0; k < 600; k++) {
                if (!late) world->margin.span = 0;
                if (dem_world_step(world, 1) != DEM_OK) break;
                if (response == 0) makes[late] += world->margin.age <= 0;
                contacts += dem_counters_get(world).contacts;
                for (d = 0; d < world->domain_count && !response; d++)  /* springs: all pairs are of spheres */
                    listed += world->domains[d].near_shaped_end - world->domains[d].near_shaped;
                for (d = 0; d < world->domain_count && late && k%50 == 0; d++)
                    for (i = world->domains[d].near_shaped; i < world->domains[d].near_shaped_end; i++) {
                        const int count = world->near.balls[d*world->near.stride + i].count;
                        few_near += count > 0 && count <= DEMI_NEAR_BALLS;
                        many_near += count == DEMI_BALLS_ALL;
                    }
            }
            CHECK_STR(dem_world_error_get(world), "");
            CHECK_EQ(k, 600);
            hash[late] = dem_world_hash_get(world);
            if (late && !response) CHECK_EQ(hash[0], hash[1]);
            dem_world_destroy(world);
        }
        if (getenv("SEARCH_NUMBERS"))
            printf("%d pairs with a list, %d without, %d contacts; made %d and %d times\n", few_near, many_near, contacts,
                   (int)makes[0], (int)makes[1]);
        CHECK_EQ(listed, 0);
        CHECK(few_near > 500);
        CHECK(many_near > 20);                  /* with impulses */
        CHECK(contacts > 50000);
        CHECK(makes[0] > 3*makes[1]);
    }
    TEST("the neighbour list stays complete with every integrator when all grains brake within one step") {
        int i, m;
        for (i = DEM_INTEGRATOR_VELOCITY_VERLET; i <= DEM_INTEGRATOR_LEAPFROG; i++)
            for (m = 0; m < METHODS; m++) {
                const double dt = 1e-5, r = 1e-3, skin = 1e-4, speed = 6;
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_world *world;
                dem_material grain;
                brake b;
                dem_body left, right;
                int step, contacts, wrong = 0;
                b.start = 0.5*dt; b.dt = dt;
                desc.threads = 1;
                desc.integrator = (dem_integrator)i;
                desc.search = methods[m];
                desc.skin = (dem_real)skin;
                desc.dt = (dem_real)dt;
                desc.allow_large_dt = 1;
                desc.force = brake_force;
                desc.force_user = &b;
                world = dem_world_create(&desc);
                grain = scene_material(world, 1e6, 1, 0, 0);
                /* apart by a hair more than the skin; two steps at 6 m/s bring them together */
                left = dem_sphere_add(world, grain, (dem_real)r, at(0, 0, 0));
                right = dem_sphere_add(world, grain, (dem_real)r, at(2*r + 1.05*skin, 0, 0));
                scene_move(world, left, at(speed/2, 0, 0), at(0, 0, 0));
                scene_move(world, right, at(-speed/2, 0, 0), at(0, 0, 0));
                for (step = 0; step < 4; step++) {
                    CHECK_EQ(scene_step(world, 1), DEM_OK);
                    wrong += wrong_pairs(world, &desc, 0, &contacts);
                }
                CHECK_EQ(wrong, 0);
                dem_world_destroy(world);
            }
    }
    TEST("a skin that the library chooses never makes a periodic box too short that was long "
         "enough") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material grain;
        uint64_t seed = 11;
        int i;
        desc.threads = 1;
        desc.dt = DEM_R(2e-6);
        desc.allow_large_dt = 1;
        desc.boundary[0] = DEM_BOUNDARY_PERIODIC;
        desc.domain = box_of(0, 0, 0, 4.5e-3, 0.03, 0.03);      /* a slice of 4.5 radii */
        world = dem_world_create(&desc);
        grain = scene_material(world, 1e8, 1, 0, 0);
        for (i = 1; i < 3; i++) {
            dem_wall_plane_add(world, grain, at(0, 0, 0), at(0, i == 1, i == 2));
            dem_wall_plane_add(world, grain, at(0, 0.03, 0.03), at(0, -(i == 1), -(i == 2)));
        }
        for (i = 0; i < 25; i++) {              /* few: a wide skin pays */
            dem_body b = dem_sphere_add(world, grain, DEM_R(1e-3),
                                        at(2e-3, 3e-3 + 5e-3*(i%5), 3e-3 + 5e-3*(i/5)));
            scene_move(world, b, scene_at(&seed, 0, 0, 4, -2, 4, -2), at(0, 0, 0));
        }
        CHECK_EQ(scene_step(world, 4000), DEM_OK);
        dem_world_destroy(world);
    }
    TEST("many grains inserted at once into a world with contact history find their own contacts") {
        int m;
        for (m = 0; m < METHODS; m++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_world *world;
            dem_material grain;
            int contacts;
            desc.threads = 1;
            desc.search = methods[m];
            world = dem_world_create(&desc);
            grain = scene_material(world, 1e6, 0.5, 0.3, 0);
            scene_block(world, grain, 3, 3, 3, 1e-3, 1, 0.1, 1);
            CHECK_EQ(scene_step(world, 20), DEM_OK);
            scene_block(world, grain, 8, 8, 8, 1e-3, 1, 0.1, 2);  /* over the first: overlaps */
            CHECK_EQ(dem_candidates_rebuild(world), DEM_OK);
            CHECK_EQ(wrong_pairs(world, &desc, 1, &contacts), 0);
            dem_world_destroy(world);
        }
    }

    TEST("bodies in contact stay so when gravity, the only rail or joint, or the deformation of the cell ends") {
        int what;
        for (what = 0; what < ENDINGS; what++) {
            const double fresh = speed_after(what, -1), kept = speed_after(what, 0);
            CHECK(fresh > 0 && fresh < 0.97);          /* they have collided */
            CHECK_NEAR(kept, fresh, sizeof(dem_real) == 4 ? 1e-5 : 1e-9);
        }
    }
    return test_end();
}
