/* Bodies that change their size: dem_body_radius_set and desc.growth. Loads rise by the growth, contact histories stay,
   mass, lists, time step and ledger follow. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static void must(dem_world *world, dem_result result) {
    CHECK_EQ(result, DEM_OK);
    if (result != DEM_OK) puts(dem_world_error_get(world));
}
enum { BALL, EGG, PAIR, CUBE, ROCK, SHAPES };
/* A shape 8 mm high along z. */
static dem_shape shape_of(dem_world *world, int kind) {
    static const dem_real two[6] = {0, DEM_R(-2e-3), 0, 0, DEM_R(2e-3), 0};
    static const dem_real apart[6] = {DEM_R(-3e-3), 0, 0, DEM_R(3e-3), 0, 0};
    dem_cluster_desc cluster = DEM_CLUSTER_DESC;
    dem_real corner[24];
    dem_shape none;
    int k;
    none.id = 0;
    for (k = 0; k < 24; k++) corner[k] = (k/3 >> k%3 & 1) ? DEM_R(4e-3) : DEM_R(-4e-3);
    cluster.count = 2;
    cluster.positions = two;
    cluster.radius = DEM_R(4e-3);
    if (kind == EGG) return dem_shape_ellipsoid_add(world, at(5e-3, 5e-3, 4e-3));
    if (kind == PAIR) return dem_shape_cluster_add(world, &cluster);
    if (kind == CUBE) return dem_shape_polyhedron_add(world, 8, corner);
    if (kind == ROCK) {
        dem_shape part[2];
        part[0] = part[1] = dem_shape_polyhedron_add(world, 8, corner);
        return dem_shape_union_add(world, 2, part, apart, 0);
    }
    return none;
}
static dem_body body_of(dem_world *world, dem_material stuff, int kind, dem_vec3 x) {
    const dem_shape shape = shape_of(world, kind);
    return shape.id ? dem_body_add(world, stuff, shape, x, dem_quat_make(1, 0, 0, 0))
                    : dem_sphere_add(world, stuff, DEM_R(4e-3), x);
}

static void no_look(const dem_contact_info *c, dem_real *memory, void *user) { (void)c; (void)memory; (void)user; }

/* ---- a body under a load grows ---- */

typedef struct plan { double rate; uint32_t slot; double until; } plan;
static dem_real grows(const dem_body_state *body, dem_body id, double time, void *user) {
    const plan *p = (const plan *)user;
    (void)body;
    return (dem_real)(id.slot == p->slot && time < p->until ? p->rate : 0);
}
static dem_world *column(int kind, dem_response response, plan *p, dem_body *low, dem_body *load) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = scene_stuff(1e7, 0.3, 0, 0);
    dem_world *world;
    desc.response = response;
    desc.threads = 1;
    desc.gravity = at(0, 0, -10);
    desc.ledger = 1;
    if (response == DEM_RESPONSE_IMPULSES) desc.dt = DEM_R(5e-5);
    else { desc.normal_law = DEM_NORMAL_LINEAR; stuff.stiffness = DEM_R(5e4); }
    desc.growth = p->rate < 0 || p->rate > 0 ? grows : 0;
    desc.growth_user = p;
    desc.growth_interval = DEM_R(1e-4);
    world = dem_world_create(&desc);
    {
        const dem_material m = dem_material_add(world, &stuff);
        dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        *low = body_of(world, m, kind, at(0, 0, 4e-3));
        *load = dem_sphere_add(world, m, DEM_R(8e-3), at(0, 0, 16e-3));
    }
    p->slot = low->slot;
    return world;
}
static void lifts(int kind, dem_response response) {
    plan p = {0, 0, 0};
    dem_body low, load;
    dem_world *world;
    dem_ledger l;
    double z, r, first, weight, high, rise;
    p.rate = 4e-3;
    p.until = 1e9;
    world = column(kind, response, &p, &low, &load);
    p.until = 0;
    must(world, dem_world_run(world, 0.05, 0, 0));
    z = (double)scene_state(world, load).position.z;
    r = (double)scene_state(world, low).radius;
    first = (double)scene_state(world, low).mass;
    p.until = dem_world_time_get(world) + 0.05;
    must(world, dem_world_run(world, 0.07, 0, 0));
    high = (double)scene_state(world, low).radius/r;
    CHECK(high > 1.02);
    /* of a load of radius 8 mm on top of the body; of a pair, between its two spheres */
    rise = 8e-3*(high - 1);
    if (kind == PAIR)
        rise = 4e-3*high + sqrt(pow(8e-3 + 4e-3*high, 2) - pow(2e-3*high, 2)) - 4e-3 - sqrt(1.44e-4 - 4e-6);
    CHECK_REL(scene_state(world, low).mass, first*high*high*high, sizeof(dem_real) == 8 ? 1e-12 : 1e-5);
    weight = 10*((double)scene_state(world, low).mass - first);
    /* springs of 5e4 N/m; impulses leave 5e-4 of the radius (DEMI_LEFT) as an overlap, at two contacts */
    CHECK_NEAR(scene_state(world, load).position.z - z, rise,
               response == DEM_RESPONSE_IMPULSES ? 1.5e-5 : weight/5e4 + 1e-7);
    l = dem_ledger_get(world);
    if (response == DEM_RESPONSE_SPRINGS) {
        /* single precision: the ledger does not see the rounding of the load's height, up to eps/4 of it on average
           and with the same sign in many steps, against its weight */
        CHECK_NEAR(l.residual, 0, sizeof(dem_real) == 8 ? 1e-3*l.throughput
                   : fmin(5e-2*l.throughput, 1.2e-7/4*(double)dem_world_steps_get(world)*z*10*
                          (double)scene_state(world, load).mass));
        /* the lift, and dashpots that see the centres move apart */
        CHECK_NEAR(l.growth, (double)scene_state(world, load).mass*10*rise, 0.5*l.growth);
    }
    dem_world_destroy(world);
}

/* ---- a packing with friction ---- */

static double swells_at = 1;
static dem_real swells(const dem_body_state *body, dem_body id, double time, void *user) {
    (void)time; (void)user; (void)body;
    return (dem_real)(swells_at*(0.01 + 0.002*(id.slot%5)));         /* m/s */
}
enum { GRAINS = 120 };
static dem_world *packing(dem_response response, int mixed, double interval) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material stuff;
    int k;
    desc.domain = box_of(0, 0, 0, 0.08, 0.045, 0.03);
    for (k = 0; k < 2; k++) desc.boundary[k] = DEM_BOUNDARY_PERIODIC;
    desc.threads = 1;
    desc.response = response;
    desc.ledger = 1;
    desc.gravity = at(0, 0, -10);
    desc.dt = (dem_real)(response == DEM_RESPONSE_IMPULSES ? 1e-4 : 1e-5);
    desc.growth = swells;
    desc.growth_interval = (dem_real)interval;
    world = dem_world_create(&desc);
    stuff = scene_material(world, 1e6, 0.5, 0.4, 0);
    dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1));
    CHECK_EQ(dem_spheres_fill(world, stuff, DEM_R(2e-3), dem_region_make(box_of(0, 0, 0, 0.08, 0.045, 0.03)), GRAINS, 1),
             GRAINS);
    for (k = EGG; k < SHAPES && mixed; k++) {
        const dem_body body = body_of(world, stuff, k, at(0.016*k, 0.015, 0.045));
        CHECK(body.slot > 0);
    }
    return world;
}
/* Sum over all contacts of the magnitudes of their histories, and their number. */
typedef struct told { int count; double sum; } told;
static void tell(const dem_contact_info *info, dem_real *memory, void *user) {
    told *t = (told *)user;
    int k;
    (void)info;
    for (k = 0; k < 3; k++) t->sum += fabs((double)memory[k]);
    t->count++;
}

/* ---- functions that look at velocities ---- */

/* Keeps the velocity that a function receives, m/s; its numbers depend on it. */
static dem_real wears_by_speed(const dem_body_state *body, dem_body id, double time, void *user) {
    (void)id; (void)time;
    *(double *)user = (double)body->velocity.z;
    return (dem_real)(-1e-4*fabs((double)body->velocity.z));
}
static void notes_speed(dem_real *reals, const dem_real *rates, const dem_body_state *body, dem_body id, double time,
                        dem_real dt, void *user) {
    (void)rates; (void)id; (void)time; (void)dt;
    reals[0] = body->velocity.z;
    *(double *)user = (double)body->velocity.z;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("a growing body lifts its load by its growth, and the ledger books the lift as work") {
        int kind;
        for (kind = 0; kind < SHAPES; kind++) {
            lifts(kind, DEM_RESPONSE_SPRINGS);
            lifts(kind, DEM_RESPONSE_IMPULSES);
        }
    }
    TEST("contact histories of all shapes stay when radii change, and forces follow") {
        int response;
        for (response = 0; response < 2; response++) {
            dem_world *world = packing(response ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS, 1, 1e9);
            told before = {0, 0}, after = {0, 0};
            int k;
            must(world, dem_world_run(world, 0.06, 0, 0));
            dem_contacts_each(world, tell, &before);
            CHECK(before.count > 10 && (response || before.sum > 0));
            for (k = 0; k < dem_bodies_get(world).count; k++) {
                const dem_body id = dem_body_id_get(world, k);
                must(world, dem_body_radius_set(world, id, scene_state(world, id).radius*DEM_R(1.000001)));
            }
            dem_contacts_each(world, tell, &after);         /* computes forces without a step */
            CHECK_EQ(after.count, before.count);
            if (response == 0) CHECK_REL(after.sum, before.sum, sizeof(dem_real) == 8 ? 1e-12 : 1e-5);
            must(world, dem_world_step(world, 5));
            dem_world_destroy(world);
        }
    }
    TEST("a block held on a slope by friction does not creep while it grows") {
        const dem_real c = DEM_R(4e-3);
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material stuff;
        dem_cluster_desc cluster = DEM_CLUSTER_DESC;
        dem_real x[24];
        dem_body block;
        double start;
        int k;
        for (k = 0; k < 24; k++) x[k] = (k/3 >> k%3 & 1) ? c : -c;
        desc.gravity = at(-2, 0, -9.6);
        desc.threads = 1;
        world = dem_world_create(&desc);
        stuff = scene_material(world, 1e7, 0.3, 0.5, 0);
        dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1));
        cluster.count = 8;
        cluster.positions = x;
        cluster.radius = c;
        block = dem_body_add(world, stuff, dem_shape_cluster_add(world, &cluster), at(0, 0, 8e-3), dem_quat_make(1, 0, 0, 0));
        must(world, dem_world_run(world, 0.3, 0, 0));
        start = (double)scene_state(world, block).position.x;
        for (k = 0; k < 60; k++) {
            must(world, dem_body_radius_set(world, block, scene_state(world, block).radius*DEM_R(1.00001)));
            must(world, dem_world_run(world, 0.0005, 0, 0));
        }
        CHECK_NEAR(scene_state(world, block).position.x, start, 1e-6);
        dem_world_destroy(world);
    }
    TEST("bodies in slabs grow as in one world, and the ledger has the same work of growth") {
        const int steps = 60;
        dem_world *a = packing(DEM_RESPONSE_SPRINGS, 1, 0), *c = packing(DEM_RESPONSE_SPRINGS, 1, 0);
        dem_slabs_desc deal = DEM_SLABS_DESC;
        dem_slabs *slabs;
        dem_ledger la, lc;
        double most = 0;
        int k;
        must(a, dem_world_step(a, 2*steps));
        must(c, dem_world_step(c, steps));
        deal.count = 2;
        slabs = dem_slabs_create(c, &deal);
        CHECK(slabs != 0);
        CHECK_EQ(dem_slabs_step(slabs, steps), DEM_OK);
        CHECK_EQ(dem_slabs_collect(slabs, c), DEM_OK);
        dem_slabs_destroy(slabs);
        for (k = 0; k < dem_bodies_get(a).count; k++) {
            const dem_body id = dem_body_id_get(a, k);
            const dem_body_state s = scene_state(a, id), t = scene_state(c, id);
            most = fmax(most, fabs((double)(s.radius - t.radius)) + fabs((double)(s.position.z - t.position.z)));
        }
        CHECK_NEAR(most, 0, sizeof(dem_real) == 8 ? 1e-10 : 1e-5);
        la = dem_ledger_get(a);
        lc = dem_ledger_get(c);
        CHECK_NEAR(lc.growth, la.growth, 1e-6*la.throughput);
        dem_world_destroy(a);
        dem_world_destroy(c);
    }
    TEST("radii follow their rates to the end of each step, or of each interval") {
        int k;
        for (k = 0; k < 2; k++) {
            dem_world *world = packing(DEM_RESPONSE_SPRINGS, 0, k ? 1e-4 : 0);
            dem_body id;
            must(world, dem_world_step(world, 100));        /* 1e-3 s */
            id.generation = 1;
            id.slot = 3;
            CHECK_NEAR(scene_state(world, id).radius, 2e-3 + 0.016*dem_world_time_get(world),
                       sizeof(dem_real) == 8 ? 1e-14 : 1e-8);
            if (k) CHECK((double)dem_counters_get(world).rebuilds < 40);
            dem_world_destroy(world);
        }
    }
    TEST("desc.growth and desc.body_reals_fn receive complete velocities, and n steps are n times one step") {
        int reals, single;
        for (reals = 0; reals < 2; reals++) {
            dem_body_state s[2];
            double number[2];
            for (single = 0; single < 2; single++) {
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_world *world;
                dem_material stuff;
                dem_body ball;
                double seen = 0, before = -1;
                dem_real read = 0;
                int k, off = 0;
                desc.dt = DEM_R(2e-5);
                desc.gravity.z = DEM_R(-9.81);
                if (reals) {
                    desc.body_reals = "speed";
                    desc.body_reals_fn = notes_speed;
                    desc.body_reals_user = &seen;
                } else {
                    desc.growth = wears_by_speed;
                    desc.growth_user = &seen;
                }
                world = dem_world_create(&desc);
                stuff = scene_material(world, 1e7, 0.5, 0, 0);
                dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1));
                ball = dem_sphere_add(world, stuff, DEM_R(5e-3), at(0, 0, 5.1e-3));
                dem_body_get(world, ball, &s[single]);
                s[single].velocity.z = -1;              /* an impact, in which the force changes in every step */
                dem_body_set(world, ball, &s[single]);
                for (k = 0; k < (single ? 60 : 1); k++) {
                    must(world, dem_world_step(world, single ? 1 : 60));
                    s[single] = scene_state(world, ball);
                    /* radii follow their rates from the beginning of a step, numbers theirs at its end */
                    if (!reals && k) off += seen < before || seen > before;
                    if (reals && single) off += seen < (double)s[1].velocity.z || seen > (double)s[1].velocity.z;
                    before = (double)s[single].velocity.z;
                }
                CHECK_EQ(off, 0);
                if (reals) dem_body_reals_get(world, ball, &read);
                number[single] = (double)read;
                dem_world_destroy(world);
            }
            CHECK_NEAR(s[1].radius, s[0].radius, 0);
            CHECK_NEAR(s[1].velocity.z, s[0].velocity.z, 0);
            CHECK_NEAR(number[1], number[0], 0);
        }
    }
    TEST("what springs gain or lose when the scene changes between two steps is growth in the ledger, and no residual") {
        int kind, change;
        for (kind = 0; kind < SHAPES; kind++)
            for (change = 0; change < 6; change++) {
                plan still = {0, 0, 0};
                dem_body low, load;
                dem_world *w = column(kind, DEM_RESPONSE_SPRINGS, &still, &low, &load);
                dem_material stuff = {1};
                dem_wall floor = {1};
                dem_body_state s;
                dem_pair pair;
                dem_ledger before, after;
                must(w, dem_world_run(w, 0.1, 0, 0));
                before = dem_ledger_get(w);
                CHECK(before.elastic > 0);
                s = scene_state(w, load);
                s.position.z -= DEM_R(1e-5);
                CHECK_EQ(dem_pair_get(w, stuff, stuff, &pair), DEM_OK);
                pair.stiffness *= 2;
                /* of six things that change what springs hold */
                if (change == 0) CHECK_EQ(dem_body_remove(w, load), DEM_OK);
                if (change == 1) CHECK_EQ(dem_body_set(w, load, &s), DEM_OK);
                if (change == 2) CHECK_EQ(dem_wall_remove(w, floor), DEM_OK);
                if (change == 3) body_of(w, stuff, kind, demi_add(s.position, at(0, 0, 0.0115)));
                if (change == 4) CHECK_EQ(dem_pair_set(w, stuff, stuff, &pair), DEM_OK);
                if (change == 5) CHECK_EQ(dem_body_radius_set(w, low, s.radius*DEM_R(1.001)), DEM_OK);
                CHECK(dem_contacts_each(w, no_look, 0) >= 0);
                after = dem_ledger_get(w);
            
                CHECK(fabs(after.elastic - before.elastic) > 1e-3*before.elastic);
                CHECK_NEAR(after.residual - before.residual, 0, 1e-5*(before.elastic + after.elastic));
                CHECK_NEAR(after.tangent - before.tangent, 0, 1e-5*(before.elastic + after.elastic));
                CHECK_EQ(scene_step(w, 1), DEM_OK);
                after = dem_ledger_get(w);
                CHECK_NEAR(after.residual - before.residual, 0, 1e-2*(before.elastic + after.elastic));
                dem_world_destroy(w);
            }
    }
    TEST("a step that is chosen shrinks with the grains") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world = dem_world_create(&desc);
        const dem_material stuff = scene_material(world, 1e7, 0.5, 0, 0);
        dem_body one = dem_sphere_add(world, stuff, DEM_R(1e-3), at(0, 0, 0));
        double dt;
        dem_sphere_add(world, stuff, DEM_R(1e-3), at(0.1, 0, 0));
        must(world, dem_world_step(world, 1));
        dt = (double)dem_counters_get(world).dt;
        must(world, dem_body_radius_set(world, one, DEM_R(5e-4)));
        must(world, dem_world_step(world, 1));
        CHECK((double)dem_counters_get(world).dt < 0.9*dt);
        CHECK_REL(scene_state(world, one).mass, 2500*4/3.0*3.14159265358979*1.25e-10, 1e-6);
        dem_world_destroy(world);
    }
    TEST("a radius that is not positive is an error, and wear down to nothing stops the run") {
        plan p = {-1, 0, 1e9};
        dem_body low, load;
        dem_world *world = column(BALL, DEM_RESPONSE_SPRINGS, &p, &low, &load);
        CHECK_EQ(dem_body_radius_set(world, low, 0), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "dem_body_radius_set: the radius of body 1 is 0 m");
        CHECK_EQ(dem_body_radius_set(world, low, (dem_real)NAN), DEM_ERROR_ARGUMENT);
        CHECK_EQ(dem_world_run(world, 0.01, 0, 0), DEM_ERROR_UNSTABLE);
        CHECK_STR(dem_world_error_get(world), "(desc.growth), must stay > 0");
        dem_world_destroy(world);
    }
    return test_end();
}
