/* Random scenes of spheres and planes in dem.h and in a naive simulator, which was written from docs/theory.md without
   the source of dem.h: both agree to rounding. Relations between runs of dem.h cannot show an error that all runs have;
   this comparison can. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"
#include "naive.c"

enum { MOST = 20, EARLY = 100 };                   /* spheres; steps to the first comparison */
/* A random scene in both simulators. `laws` is the naive form of all choices. */
typedef struct both {
    naive_laws laws;
    double friction, rolling;              /* largest coefficients; 0: none */
    double held, sticky;                   /* 1: mu_s above mu; N/m: half the largest adhesion */
    int stiffness;                         /* materials with a given stiffness, of the linear law */
    int set;                               /* one pair gets values of its own */
    int planes, axes;                      /* planes; periodic axes, one bit each */
    int materials, spheres, fixed;
    double edge[3];                        /* m, of the box in which spheres begin */
    double least, most;                    /* m, radii */
    double speed;                          /* m/s, velocities are below this */
    naive *reference;
    dem_world *world;
    dem_body body[MOST];
} both;

static naive_vec naive_of(dem_vec3 v) { return vec((double)v.x, (double)v.y, (double)v.z); }
static dem_vec3 dem_of(naive_vec v) { return at(v.x, v.y, v.z); }

static dem_world *world_of(const both *s) {
    static const dem_normal_law normals[] = {DEM_NORMAL_HERTZ, DEM_NORMAL_LINEAR, DEM_NORMAL_HYSTERETIC};
    static const dem_tangent_law tangents[] = {DEM_TANGENT_NONE, DEM_TANGENT_SPRING, DEM_TANGENT_MINDLIN,
                                               DEM_TANGENT_MINDLIN_RESCALED};
    static const dem_slider sliders[] = {DEM_SLIDER_PARALLEL, DEM_SLIDER_SPRING, DEM_SLIDER_REMAINDER};
    static const dem_load loads[] = {DEM_LOAD_REPULSIVE, DEM_LOAD_ELASTIC, DEM_LOAD_MAGNITUDE};
    static const dem_rolling_law rollings[] = {DEM_ROLLING_NONE, DEM_ROLLING_CONSTANT, DEM_ROLLING_EPSD};
    static const dem_tension tensions[] = {DEM_TENSION_ALLOWED, DEM_TENSION_CLIPPED, DEM_TENSION_COMPENSATED};
    dem_world_desc desc = DEM_WORLD_DESC;
    int axis;
    desc.normal_law = normals[s->laws.normal];
    desc.tension = tensions[s->laws.tension];
    desc.tangent_law = tangents[s->laws.tangent];
    desc.slider = sliders[s->laws.slider];
    desc.friction_load = loads[s->laws.load];
    desc.rolling_law = rollings[s->laws.rolling];
    desc.impact_speed = (dem_real)s->laws.impact_speed;
    desc.gravity = dem_of(s->laws.gravity);
    desc.dt = (dem_real)s->laws.dt;
    desc.allow_large_dt = 1;
    desc.threads = 1;
    desc.domain = box_of(0, 0, 0, s->edge[0], s->edge[1], s->edge[2]);
    for (axis = 0; axis < 3; axis++)
        if (s->axes >> axis & 1) desc.boundary[axis] = DEM_BOUNDARY_PERIODIC;
    if (s->axes) desc.skin = (dem_real)(0.2*s->least);         /* a period is at least 4 radii and two skins */
    return dem_world_create(&desc);
}
static int draw(uint64_t *state, int count) { return (int)(count*scene_random(state)); }
static double draw_between(uint64_t *state, double low, double high) {
    return low + (high - low)*scene_random(state);
}

/* Random values of the materials; returns the shortest duration of a contact at 1 m/s, docs/theory.md, s. */
static double both_materials(both *s, uint64_t *state, naive_material *m) {
    double shortest = 1e30;
    int i;
    for (i = 0; i < s->materials; i++) {
        m[i].density = draw_between(state, 1000, 4000);
        m[i].young = draw_between(state, 2e6, 1e7);
        m[i].poisson = draw_between(state, 0.1, 0.4);
        m[i].restitution = draw_between(state, 0.3, 0.95);
        m[i].friction = s->friction*draw_between(state, 0.2, 1);
        m[i].rolling_friction = s->rolling*draw_between(state, 0.2, 1);
        m[i].stiffness = i < s->stiffness ? draw_between(state, 2e3, 8e3) : 0;
        m[i].friction_static = s->held*m[i].friction*draw_between(state, 1, 2);
        m[i].adhesion = s->laws.normal == NAIVE_HYSTERETIC ? s->sticky*draw_between(state, 1, 2) : 0;
        m[i].ratio = i < s->stiffness ? draw_between(state, 0.5, 1) : 0;
    }
    for (i = 0; i < s->materials; i++) {
        const double mass = 4.0/3*naive_pi*pow(s->least, 3)*m[i].density/2, R = s->least/2;
        const double E = young_eff(&m[i], &m[i]), hertz = 2.87*pow(mass*mass/(R*E*E), 0.2);
        const double linear = naive_pi*sqrt(mass/8e3);
        shortest = fmin(shortest, m[i].stiffness > 0 ? fmin(hertz, linear) : hertz);
    }
    return shortest;
}
/* A position whose overlaps with all others are below 3 % of the sum of the radii; 0: none found. */
static int both_place(const both *s, uint64_t *state, const naive_vec *x, const double *r, int i, naive_vec *out) {
    int tries, j, far_image;
    for (tries = 0; tries < 2000; tries++) {
        const double wall = 0.98*r[i];
        *out = naive_of(scene_at(state, s->edge[0], 0, s->edge[1], 0, s->edge[2], 0));
        if (s->planes > 0 && out->z < wall) continue;          /* the planes at z = 0, x = 0 and opposite */
        if (s->planes > 1 && out->x < wall) continue;
        if (s->planes > 2 && out->z > s->edge[2] - wall) continue;
        if (s->planes > 3 && out->x > s->edge[0] - wall) continue;
        for (j = 0; j < i; j++)
            if (size(between(s->reference, *out, x[j], &far_image)) < 0.97*(r[i] + r[j])) break;
        if (j == i) return 1;
    }
    return 0;
}
/* The edges of the box of a volume, m3, if possible: a period is at least 4 radii and two skins, and two planes leave
   space for one sphere. */
static void both_edges(both *s, double volume) {
    double least[3], edge = cbrt(volume);
    int axis, pass;
    for (axis = 0; axis < 3; axis++) {
        least[axis] = s->axes >> axis & 1 ? 4*s->most + 0.5*s->least : 2.2*s->most;
        s->edge[axis] = fmax(edge, least[axis]);
    }
    for (pass = 0; pass < 20; pass++)
        for (axis = 0; axis < 3; axis++)
            if (s->edge[0]*s->edge[1]*s->edge[2] > volume) s->edge[axis] = fmax(0.95*s->edge[axis], least[axis]);
}
/* Builds both forms of a scene whose choices are made. Returns 0 if memory runs out. */
static int both_build(both *s, uint64_t seed) {
    naive_material m[3];
    naive_vec x[MOST], v, spin, centre;
    double r[MOST], volume = 0, space;
    dem_material id[3];
    uint64_t state = seed;
    int i, axis, placed = 0;
    s->least = 0.002;
    s->most = 0;
    s->speed = 1;
    for (i = 0; i < s->spheres; i++) {
        r[i] = draw_between(&state, s->least, 3*s->least);
        s->most = fmax(s->most, r[i]);
        volume += 4.0/3*naive_pi*r[i]*r[i]*r[i];
    }
    s->laws.dt = both_materials(s, &state, m)/50;
    for (space = volume/0.3; placed < s->spheres; space *= 1.1) {      /* spheres fill 0.3 of the box, or less */
        both_edges(s, space);
        for (axis = 0; axis < 3; axis++) s->laws.period[axis] = s->axes >> axis & 1 ? s->edge[axis] : 0;
        naive_free(s->reference);
        s->reference = naive_create(&s->laws);
        if (!s->reference) return 0;
        for (placed = 0; placed < s->spheres; placed++)
            if (!both_place(s, &state, x, r, placed, &x[placed])) break;
    }
    s->world = world_of(s);
    if (!s->world) return 0;
    for (i = 0; i < s->materials; i++) {
        dem_material_desc d = DEM_MATERIAL_DESC;
        d.density = (dem_real)m[i].density;
        d.young = (dem_real)m[i].young;
        d.poisson = (dem_real)m[i].poisson;
        d.restitution = (dem_real)m[i].restitution;
        d.friction = (dem_real)m[i].friction;
        d.friction_static = (dem_real)m[i].friction_static;
        d.stiffness_adhesion = (dem_real)m[i].adhesion;
        d.rolling_friction = (dem_real)m[i].rolling_friction;
        d.stiffness = (dem_real)m[i].stiffness;
        d.stiffness_ratio = (dem_real)m[i].ratio;
        id[i] = dem_material_add(s->world, &d);
        naive_material_add(s->reference, &m[i]);
    }
    if (s->set) {
        naive_pair pair = naive_pair_get(s->reference, 0, s->materials - 1);
        dem_pair p;
        dem_pair_get(s->world, id[0], id[s->materials - 1], &p);
        pair.restitution = s->laws.normal == NAIVE_HYSTERETIC ? 0.42 : 0.1;
        pair.tangent_damping = 0.5;
        p.restitution = (dem_real)pair.restitution;
        p.tangent_damping = DEM_R(0.5);
        if (s->laws.normal == NAIVE_LINEAR) pair.normal_damping = 0.3;
        p.normal_damping = (dem_real)pair.normal_damping;
        dem_pair_set(s->world, id[0], id[s->materials - 1], &p);
        naive_pair_set(s->reference, 0, s->materials - 1, pair);
    }
    for (i = 0; i < s->planes; i++) {
        const double sign = i < 2 ? 1 : -1, x_far = i == 3 ? s->edge[0] : 0, z_far = i == 2 ? s->edge[2] : 0;
        const naive_vec normal = i%2 ? vec(sign, 0, 0) : vec(0, 0, sign), point = vec(x_far, 0, z_far);
        dem_wall_plane_add(s->world, id[i%s->materials], dem_of(point), dem_of(normal));
        naive_plane_add(s->reference, i%s->materials, point, normal);
    }
    centre = times(0.5, vec(s->edge[0], s->edge[1], s->edge[2]));
    for (i = 0; i < s->spheres; i++) {
        const int material = draw(&state, s->materials), fixed = i < s->fixed;
        dem_body_state b;
        v = minus(centre, x[i]);
        v = times(0.6*s->speed/(size(v) + 1e-3), v);           /* towards the centre, and at random; fixed bodies */
        v = plus(v, 0.4*s->speed, naive_of(scene_at(&state, 1, -0.5, 1, -0.5, 1, -0.5)));      /* ignore it */
        spin = times(200, naive_of(scene_at(&state, 1, -0.5, 1, -0.5, 1, -0.5)));
        s->body[i] = dem_sphere_add(s->world, id[material], (dem_real)r[i], dem_of(x[i]));
        b = scene_state(s->world, s->body[i]);
        b.velocity = dem_of(v);
        b.spin = dem_of(spin);
        b.fixed = fixed;
        dem_body_set(s->world, s->body[i], &b);
        naive_sphere_add(s->reference, material, r[i], x[i], v, spin, fixed);
    }
    return 1;
}
static void both_free(both *s) {
    naive_free(s->reference);
    dem_world_destroy(s->world);
}
/* Largest differences of positions, velocities and surface speeds: over the least radius and over `speed`. */
typedef struct gap { double x, v, spin, force; } gap;
static gap both_gap(const both *s) {
    gap g = {0, 0, 0, 0};
    double most = 1e-12;
    int i, far_image;
    for (i = 0; i < s->spheres; i++) most = fmax(most, size(naive_get(s->reference, i).force));
    for (i = 0; i < s->spheres; i++) {
        const dem_body_state b = scene_state(s->world, s->body[i]);
        const naive_state n = naive_get(s->reference, i);
        const double r = (double)b.radius;
        g.x = fmax(g.x, size(between(s->reference, n.x, naive_of(b.position), &far_image))/s->least);
        g.v = fmax(g.v, size(minus(n.v, naive_of(b.velocity)))/s->speed);
        g.spin = fmax(g.spin, size(minus(n.spin, naive_of(b.spin)))*r/s->speed);
        g.force = fmax(g.force, size(minus(n.force, naive_of(b.force)))/most);
    }
    return g;
}
/* A scene with these laws and random other choices. */
static int both_draw(both *s, both choices, uint64_t seed) {
    uint64_t state = seed;
    *s = choices;
    s->materials = 1 + draw(&state, 3);
    s->stiffness = draw(&state, 4);
    s->set = draw(&state, 2);
    s->planes = draw(&state, 5);
    s->axes = s->planes > 1 ? 2*draw(&state, 2) : s->planes ? draw(&state, 4) : draw(&state, 8);   /* no plane is cut */
    s->spheres = s->axes ? 6 + draw(&state, MOST - 5) : 2 + draw(&state, MOST - 1);
    s->fixed = s->spheres > 3 ? draw(&state, 3) : 0;
    if (draw(&state, 3)) s->laws.gravity = naive_of(scene_at(&state, 10, -5, 10, -5, -10, -5));
    if (draw(&state, 2)) s->laws.impact_speed = draw_between(&state, 0.3, 1);
    return both_build(s, state);
}
/* Runs `scenes` random scenes and compares after 100 steps and at the end. Round-off is 1.1e-16 of a coordinate, which
   is at most 25 least radii: 3e-15 of a radius and, with 50 steps per contact, some 1e-13 of a speed per impact. 1e-11
   leaves a factor of 100 for other compilers. An impact enlarges a deviation by the path before it over R*, at most
   about 10; two more impacts make 1e-9 of it. In single precision the round-off is 5e8 times as large, and the dashpot
   of EPSD may end in another step: 2 % and 10 %. */
static naive_count compare(both choices, int scenes, uint64_t seed) {
    const int single = sizeof(dem_real) == sizeof(float);
    naive_count sum;
    int scene;
    memset(&sum, 0, sizeof sum);
    for (scene = 0; scene < scenes; scene++) {
        const int late = 200 + 200*(scene%5);
        both s;
        naive_count c;
        int part;
        if (choices.laws.normal != NAIVE_HYSTERETIC) choices.laws.normal = scene%2 ? NAIVE_LINEAR : NAIVE_HERTZ;
        CHECK(both_draw(&s, choices, seed + (uint64_t)scene));
        if (!s.world) { both_free(&s); continue; }
        for (part = 0; part < 2; part++) {
            const int steps = part ? late - EARLY : EARLY;
            const double within = single ? (part ? 0.1 : 0.02) : part ? 1e-9 : 1e-11;
            gap g;
            CHECK_EQ(scene_step(s.world, steps), DEM_OK);
            naive_step(s.reference, steps);
            g = both_gap(&s);
            CHECK_NEAR(g.x, 0, within);
            CHECK_NEAR(g.v, 0, within);
            CHECK_NEAR(g.spin, 0, within);
        }
        c = naive_counts(s.reference);
        sum.began += c.began;
        sum.slid += c.slid;
        sum.stuck += c.stuck;
        sum.attracted += c.attracted;
        sum.rolled += c.rolled;
        sum.across += c.across;
        sum.walls += c.walls;
        both_free(&s);
    }
    CHECK(sum.began >= 4*scenes);
    return sum;
}
static both choose(int tangent, double friction, int rolling, double rolling_friction) {
    both s;
    memset(&s, 0, sizeof s);
    s.laws.tangent = tangent;
    s.laws.rolling = rolling;
    s.friction = friction;
    s.rolling = rolling_friction;
    return s;
}

int main(int argc, char **argv) {
    both s;
    naive_count c;
    test_begin(argc, argv);

    TEST("spheres and planes without friction move as in a naive simulation") {
        c = compare(choose(NAIVE_SMOOTH, 0, NAIVE_FREE, 0), 10, 100);
        CHECK(c.attracted > 500 && c.across > 50 && c.walls > 100);
    }
    TEST("spheres that slide and stick by tangential springs move as in a naive simulation") {
        c = compare(choose(NAIVE_SPRING, 0.6, NAIVE_FREE, 0), 16, 200);
        CHECK(c.slid > 2000 && c.stuck > 2000 && c.across > 100 && c.walls > 100);
    }
    TEST("spheres with static friction above sliding friction move as in a naive simulation") {
        s = choose(NAIVE_SPRING, 0.6, NAIVE_FREE, 0);
        s.held = 1;
        c = compare(s, 10, 300);
        CHECK(c.slid > 1000 && c.stuck > 1000);
    }
    TEST("spheres with Mindlin's friction, rescaled or not, move as in a naive simulation") {
        c = compare(choose(NAIVE_MINDLIN, 0.6, NAIVE_FREE, 0), 6, 400);
        CHECK(c.slid > 500 && c.stuck > 500);
        c = compare(choose(NAIVE_RESCALED, 0.6, NAIVE_FREE, 0), 6, 500);
        CHECK(c.slid > 500 && c.stuck > 500);
    }
    TEST("spheres with a rolling resistance of constant moment move as in a naive simulation") {
        c = compare(choose(NAIVE_SPRING, 0.6, NAIVE_CONSTANT, 1), 10, 600);
        CHECK(c.rolled > 1000 && c.slid + c.stuck - c.rolled > 300);
    }
    TEST("spheres with an elastic-plastic rolling spring move as in a naive simulation") {
        c = compare(choose(NAIVE_SPRING, 0.6, NAIVE_EPSD, 0.3), 10, 700);
        CHECK(c.rolled > 1000 && c.slid + c.stuck - c.rolled > 1000);
    }
    TEST("plastic spheres that adhere move as in a naive simulation") {
        s = choose(NAIVE_SPRING, 0.6, NAIVE_EPSD, 0.3);
        s.laws.normal = NAIVE_HYSTERETIC;
        s.sticky = 1000;
        c = compare(s, 10, 800);
        CHECK(c.attracted > 500 && c.slid > 1000 && c.stuck > 1000);
    }
    TEST("spheres whose dashpots do not attract move as in a naive simulation") {
        s = choose(NAIVE_SPRING, 0.6, NAIVE_EPSD, 0.3);
        s.laws.tension = NAIVE_CLIPPED;
        c = compare(s, 6, 900);
        CHECK_EQ(c.attracted, 0);
        s.laws.tension = NAIVE_COMPENSATED;
        c = compare(s, 6, 1000);
        CHECK_EQ(c.attracted, 0);
    }
    TEST("every slider and every load of Coulomb's limit move spheres as in a naive simulation") {
        s = choose(NAIVE_SPRING, 0.4, NAIVE_FREE, 0);
        s.laws.slider = NAIVE_SLIDER_SPRING;
        s.laws.load = NAIVE_ELASTIC;
        c = compare(s, 6, 1100);
        CHECK(c.slid > 1000);
        s.laws.slider = NAIVE_REMAINDER;
        s.laws.load = NAIVE_MAGNITUDE;
        c = compare(s, 6, 1200);
        CHECK(c.slid > 1000);
    }
    TEST("a change of friction by a millionth separates the two simulations") {
        int a, b;
        CHECK(both_draw(&s, choose(NAIVE_SPRING, 0.6, NAIVE_FREE, 0), 200));
        for (a = 0; a < s.materials; a++)
            for (b = a; b < s.materials; b++) {
                naive_pair pair = naive_pair_get(s.reference, a, b);
                pair.friction *= 1 + 1e-6;
                naive_pair_set(s.reference, a, b, pair);
            }
        CHECK_EQ(scene_step(s.world, 400), DEM_OK);
        naive_step(s.reference, 400);
        CHECK(both_gap(&s).v > 1e-8);                      /* ten times what compare admits at the end */
        both_free(&s);
    }
    return test_end();
}
