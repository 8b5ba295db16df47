/* Numbers of one's own on grains and walls (desc.body_reals): carried along, named, saved, sent and written; seen by
   laws, whose rates are summed in a fixed order; heat (examples/laws/heat.h) and charge (charge.h) against closed forms. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"
#include "../../examples/laws/heat.h"
#include "../../examples/laws/charge.h"

static const int wide = sizeof(dem_real) == sizeof(double);
static const double pi = 3.141592653589793;
static const dem_real silver[] = {400, 100}, specific[] = {235, 500};
static heat hot = {silver, specific, 0, 0};

/* --- a mixture that exchanges: numbers 0 (heat, as above), 1 (is handed over whole: what a gains b loses), 2 (age of
       contact) --- */
static void exchange(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const dem_contact_who *w = &c->who;
    const dem_real go = DEM_R(0.3)*(w->reals_b[1] - w->reals_a[1]);
    heat_law(c, memory, f);
    w->rate_a[1] += go;
    w->rate_b[1] -= go;
    w->rate_a[2] += 1;
    w->rate_b[2] += 1;
}
static dem_world_desc desc_of(dem_law_fn law, void *user, const char *reals, double dt) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.law = law;
    desc.law_user = user;
    desc.law_memory = 5;
    desc.law_vectors = 1;
    desc.law_who = 1;
    desc.body_reals = reals;
    desc.dt = (dem_real)dt;
    desc.threads = 1;
    return desc;
}
/* A box with spheres of two sizes and materials, clusters and ellipsoids on a mesh, under gravity; each with numbers that
   its id decides. shaped 0: spheres alone. */
static dem_world *mixture(int shaped, dem_search search, double skin) {
    dem_world_desc desc = desc_of(exchange, &hot, "temperature money age", 5e-6);
    const dem_real centres[] = {DEM_R(-5e-4), 0, 0, DEM_R(5e-4), 0, 0};
    dem_real p[12] = {DEM_R(-0.1), DEM_R(-0.1), 0, DEM_R(0.1), DEM_R(-0.1), 0, DEM_R(0.1), DEM_R(0.1), 0, DEM_R(-0.1),
                      DEM_R(0.1), 0};
    int32_t t[6] = {0, 1, 2, 0, 2, 3};
    dem_mesh mesh = {4, 2, p, t};
    const dem_real warm[3] = {400, 0, 0};
    const dem_box room = box_of(0, 0, 0.001, 0.03, 0.016, 0.02);
    dem_cluster_desc two = DEM_CLUSTER_DESC;
    dem_world *w;
    dem_material a, b;
    dem_bodies all;
    int i;
    desc.gravity = at(0, 0, -60);
    desc.threads = 1;
    desc.search = search;
    desc.skin = (dem_real)skin;
    desc.boundary[0] = DEM_BOUNDARY_PERIODIC;
    desc.domain = box_of(0, -1, -1, 0.03, 1, 1);
    w = dem_world_create(&desc);
    a = scene_material(w, 1e6, 0.4, 0.4, 0);
    b = scene_material(w, 2e6, 0.6, 0.2, 0);
    CHECK_EQ(dem_wall_reals_set(w, dem_wall_mesh_add(w, a, &mesh), warm), DEM_OK);
    dem_wall_plane_add(w, a, at(0, 0, 0), at(0, 1, 0));
    dem_wall_plane_add(w, a, at(0, 0.016, 0), at(0, -1, 0));
    if (shaped) {
        two.count = 2;
        two.positions = centres;
        two.radius = DEM_R(7e-4);
        dem_bodies_fill(w, a, dem_shape_cluster_add(w, &two), dem_region_make(room), 40, 6);
        dem_bodies_fill(w, a, dem_shape_ellipsoid_add(w, at(1.2e-3, 8e-4, 6e-4)), dem_region_make(room), 40, 5);
    }
    dem_spheres_fill(w, a, DEM_R(8e-4), dem_region_make(room), shaped ? 80 : 300, 7);
    dem_spheres_fill(w, b, DEM_R(5e-4), dem_region_make(room), 100, 8);
    all = dem_bodies_get(w);
    for (i = 0; i < all.count; i++) {
        const dem_real own[3] = {300, (dem_real)(all.slots[i]%7), 0};
        CHECK_EQ(dem_body_reals_set(w, dem_body_id_get(w, i), own), DEM_OK);
    }
    return w;
}
static double sum_of(const dem_world *w, int k) {
    const dem_bodies all = dem_bodies_get(w);
    double sum = 0;
    int i;
    for (i = 0; i < all.count; i++) sum += (double)all.reals[i*all.real_count + k];
    return sum;
}
/* Largest difference of number k, body by body. */
static double apart(const dem_world *a, const dem_world *b, int k) {
    const dem_bodies one = dem_bodies_get(a);
    double most = 0;
    int i;
    for (i = 0; i < one.count; i++) {
        dem_real x[DEM_BODY_REALS], y[DEM_BODY_REALS];
        const dem_body id = dem_body_id_get(a, i);
        CHECK_EQ(dem_body_reals_get(a, id, x), DEM_OK);
        CHECK_EQ(dem_body_reals_get(b, id, y), DEM_OK);
        most = fmax(most, fabs((double)(x[k] - y[k])));
    }
    return most;
}
/* What walls have gained of number k, the mesh's mass taken as 1. */
static double wall_gain(const dem_world *w, int k) {
    double sum = 0;
    int i;
    for (i = 1; i <= 3; i++) {
        dem_wall_loads loads;
        dem_wall wall;
        wall.id = i;
        if (dem_wall_loads_get(w, wall, &loads) == DEM_OK) sum += loads.gained[k];
    }
    return sum;
}
static int file_has(const char *path, const char *words) {
    static char text[200000];
    FILE *file = fopen(path, "rb");
    size_t n, i;
    if (!file) return 0;
    n = fread(text, 1, sizeof text - 1, file);
    fclose(file);
    for (i = 0; i + strlen(words) <= n; i++) if (!memcmp(text + i, words, strlen(words))) return 1;
    return 0;
}
/* Heat alone: the grains stay where they are. */
static void heat_only(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    heat_law(c, memory, f);
    memset(f, 0, sizeof *f);
}
/* A row of n spheres of 1 mm that overlap by 1 % of the radius, the first at 400, the others at 300. */
static dem_world *chain(int n, dem_body *ids, int threads) {
    dem_world_desc desc = desc_of(heat_only, &hot, "temperature", 1e-6);
    dem_world *w;
    dem_material m;
    int i;
    desc.allow_large_dt = 1;
    desc.threads = threads;
    w = dem_world_create(&desc);
    m = scene_material(w, 1e6, 0.5, 0.3, 0);
    for (i = 0; i < n; i++) {
        const dem_real T = i == 0 ? 400 : 300;
        ids[i] = dem_sphere_add(w, m, DEM_R(1e-3), at(1.99e-3*i, 0, 0));
        CHECK_EQ(dem_body_reals_set(w, ids[i], &T), DEM_OK);
    }
    return w;
}
/* A row of eight that touch as above, whose step of 1e-6 s is `share` of what heat bears in the middle of the row. told: the
   law tells its rates; given: dt is. */
static dem_world *hot_row(double share, int told, int given) {
    static dem_real capacity[1];
    static heat here = {silver, capacity, 0, 0};
    dem_world_desc desc = desc_of(heat_only, &here, "temperature", given ? 1e-6 : 0);
    dem_world *w;
    dem_material m;
    int i;
    capacity[0] = (dem_real)(2*2*400*sqrt(0.5e-3*1e-5)/(2500*4/3.0*pi*1e-9)*1e-6/share);
    desc.law_rate = told ? heat_rate : 0;
    desc.threads = 1;
    w = dem_world_create(&desc);
    m = scene_material(w, 1e6, 0.5, 0.3, 0);
    for (i = 0; i < 8; i++) {
        const dem_real T = i%2 ? 400 : 300;
        const dem_body id = dem_sphere_add(w, m, DEM_R(1e-3), at(1.99e-3*i, 0, 0));
        CHECK_EQ(dem_body_reals_set(w, id, &T), DEM_OK);
    }
    return w;
}
/* How far temperatures are outside 300 .. 400. */
static double beyond(const dem_world *w) {
    const dem_bodies b = dem_bodies_get(w);
    double most = 0;
    int i;
    for (i = 0; i < b.count; i++) most = fmax(most, fabs((double)b.reals[i] - 350) - 50);
    return most;
}
static double temperature(const dem_world *w, dem_body id) {
    dem_real T = 0;
    dem_body_reals_get(w, id, &T);
    return (double)T;
}
/* The ends keep theirs: a heat bath. */
static void bath(dem_real *reals, const dem_real *rates, const dem_body_state *body, dem_body id, double time, dem_real dt,
                 void *user) {
    const dem_body *ends = (const dem_body *)user;
    (void)body; (void)time;
    if (id.slot != ends[0].slot && id.slot != ends[1].slot) reals[0] += rates[0]*dt;
}

/* A field of 1 kV/m along x, on what charge a grain carries. */
static void electric(const dem_body_state *body, dem_body id, double time, dem_vec3 *force, dem_vec3 *torque, void *user) {
    (void)id; (void)time; (void)torque; (void)user;
    force->x = 1000*body->reals[0];
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("body_reals takes at most eight names of letters, digits and _; bad names and calls without numbers are "
         "rejected") {
        static const char *const bad[] = {"a b c d e f g h i", "temp,charge", "a2345678901234567890bcde", "x=1"};
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *w;
        dem_real reals[DEM_BODY_REALS] = {0};
        dem_material m;
        dem_body body;
        int i;
        for (i = 0; i < 4; i++) {
            desc.body_reals = bad[i];
            CHECK(!dem_world_create(&desc));
            CHECK_STR(dem_world_create_error_get(&desc), "at most 8 words of at most 23 letters");
        }
        desc.body_reals = 0;
        desc.body_reals_fn = bath;
        CHECK_STR(dem_world_create_error_get(&desc), "body_reals names no numbers");
        desc.body_reals_fn = 0;
        w = dem_world_create(&desc);
        m = scene_material(w, 1e6, 0.5, 0, 0);
        body = dem_sphere_add(w, m, DEM_R(1e-3), at(0, 0, 0));
        CHECK_EQ(dem_body_reals_set(w, body, reals), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(w), "name the numbers in desc.body_reals");
        CHECK(!dem_bodies_get(w).reals && dem_bodies_get(w).real_count == 0);
        dem_world_destroy(w);
        desc.body_reals = "  temperature   charge_2 ";
        w = dem_world_create(&desc);
        CHECK_STR(dem_world_desc_get(w).body_reals, "temperature charge_2");
        m = scene_material(w, 1e6, 0.5, 0, 0);
        body = dem_sphere_add(w, m, DEM_R(1e-3), at(0, 0, 0));
        CHECK_EQ(dem_bodies_get(w).real_count, 2);
        reals[1] = (dem_real)NAN;
        CHECK_EQ(dem_body_reals_set(w, body, reals), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(w), "number 1 is");
        reals[0] = 5; reals[1] = -2;
        CHECK_EQ(dem_body_reals_set(w, body, reals), DEM_OK);
        reals[0] = reals[1] = 0;
        CHECK_EQ(dem_body_reals_get(w, body, reals), DEM_OK);
        CHECK(reals[0] == 5 && reals[1] == -2);
        body.slot = 77;
        CHECK_EQ(dem_body_reals_get(w, body, reals), DEM_ERROR_ARGUMENT);
        dem_world_destroy(w);
    }
    TEST("numbers stay with their grains through sorting, removal, insertion, bulk setting and the start of "
         "orientations") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *w;
        dem_material m;
        dem_bodies all;
        dem_real *bulk;
        int i, k, round;
        desc.body_reals = "a b c d e f g";
        desc.gravity = at(0, 0, -9.81);
        w = dem_world_create(&desc);
        m = scene_material(w, 1e6, 0.5, 0.3, 0);
        dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1));
        dem_spheres_fill(w, m, DEM_R(1e-3), dem_region_make(box_of(0, 0, 0, 0.03, 0.03, 0.03)), 800, 3);
        all = dem_bodies_get(w);
        bulk = (dem_real *)calloc((size_t)(all.count*7), sizeof *bulk);
        for (i = 0; i < all.count*7; i++) bulk[i] = (dem_real)(10*all.slots[i/7] + (uint32_t)(i%7));
        CHECK_EQ(dem_bodies_reals_set(w, bulk), DEM_OK);
        free(bulk);
        for (round = 0; round < 4; round++) {
            dem_real none[7];
            dem_body fresh;
            CHECK_EQ(scene_step(w, 500), DEM_OK);
            all = dem_bodies_get(w);
            for (i = 0; i < all.count; i++)
                for (k = 0; k < 7; k++)
                    CHECK(all.reals[7*i + k] == (dem_real)(10*all.slots[i] + (uint32_t)k));
            for (i = 0; i < 50; i++) dem_body_remove(w, dem_body_id_get(w, (13*i)%dem_bodies_get(w).count));
            fresh = round == 2 ? dem_body_add(w, m, dem_shape_ellipsoid_add(w, at(1e-3, 8e-4, 8e-4)), at(0.015, 0.015, 0.1),
                                              dem_quat_make(1, 0, 0, 0))
                : dem_sphere_add(w, m, DEM_R(1e-3), at(0.01, 0.01, 0.05 + 0.01*round));
            CHECK_EQ(dem_body_reals_get(w, fresh, none), DEM_OK);
            for (k = 0; k < 7; k++) CHECK(none[k] >= 0 && none[k] <= 0);
            for (k = 0; k < 7; k++) none[k] = (dem_real)(10*(fresh.slot - 1) + (uint32_t)k);
            CHECK_EQ(dem_body_reals_set(w, fresh, none), DEM_OK);
        }
        dem_world_destroy(w);
    }
    TEST("exchange laws give the same numbers for any search and skin, and what one body gains the other loses") {
        int shaped, kind;
        for (shaped = 0; shaped < 2; shaped++) {
            dem_world *one = mixture(shaped, DEM_SEARCH_GRID, 0);
            const double money = sum_of(one, 1);
            CHECK_EQ(scene_step(one, 5000), DEM_OK);
            CHECK_NEAR(sum_of(one, 1) + wall_gain(one, 1), money, (wide ? 1e-12 : 1e-4)*money);
            CHECK(fabs(wall_gain(one, 1)) > 1e-4*money && sum_of(one, 0) > 300*dem_bodies_get(one).count);
            if (getenv("TEST_TABLES")) printf("%g %g %g %g\n", wall_gain(one, 1)/money, sum_of(one, 0)/dem_bodies_get(one).count, sum_of(one, 2), sum_of(one, 1)/money);
            CHECK(sum_of(one, 2) > 1);
            for (kind = 0; kind < 3; kind++) {
                dem_world *other = mixture(shaped, kind == 0 ? DEM_SEARCH_HIERARCHICAL : DEM_SEARCH_GRID,
                                           kind == 1 ? 4e-4 : kind == 2 ? 1e-4 : 0);
                CHECK_EQ(scene_step(other, 5000), DEM_OK);
                CHECK_NEAR(apart(one, other, 0), 0, wide ? 1e-6 : 1);
                CHECK_NEAR(apart(one, other, 1), 0, wide ? 1e-6 : 1e-1);
                dem_world_destroy(other);
            }
            dem_world_destroy(one);
        }
    }
    TEST("a checkpoint holds numbers, rates and wall gains and resumes to the bit; other names are rejected") {
        dem_world *one = mixture(1, DEM_SEARCH_GRID, 0), *other = mixture(1, DEM_SEARCH_GRID, 0), *third;
        dem_world_desc desc = desc_of(exchange, &hot, "warmth", 1e-5);
        CHECK_EQ(scene_step(one, 5000), DEM_OK);
        CHECK_EQ(dem_checkpoint_write(one, "build/tmp/reals.dem"), DEM_OK);
        CHECK_EQ(dem_checkpoint_read(other, "build/tmp/reals.dem"), DEM_OK);
        CHECK_NEAR(apart(one, other, 0), 0, 0);
        CHECK_NEAR(wall_gain(one, 0), wall_gain(other, 0), 0);
        CHECK_EQ(scene_step(one, 1000), DEM_OK);
        CHECK_EQ(scene_step(other, 1000), DEM_OK);
        CHECK(dem_world_hash_get(one) == dem_world_hash_get(other));
        CHECK_NEAR(wall_gain(one, 0), wall_gain(other, 0), 0);
        third = dem_world_create(&desc);
        CHECK(dem_checkpoint_read(third, "build/tmp/reals.dem") != DEM_OK);
        dem_world_destroy(one);
        dem_world_destroy(other);
        dem_world_destroy(third);
    }
    TEST("slabs exchange numbers across borders as one world does, and return them when collected") {
        int count;
        for (count = 1; count <= 4; count++) {
            dem_world *one = mixture(count%2, DEM_SEARCH_GRID, 0), *other = mixture(count%2, DEM_SEARCH_GRID, 0);
            dem_slabs_desc desc = DEM_SLABS_DESC;
            const double money = sum_of(one, 1);
            dem_slabs *slabs;
            desc.count = count;
            slabs = dem_slabs_create(other, &desc);
            CHECK(slabs != 0);
            CHECK_EQ(scene_step(one, 5000), DEM_OK);
            CHECK_EQ(dem_slabs_step(slabs, 5000), DEM_OK);
            CHECK_EQ(dem_slabs_collect(slabs, other), DEM_OK);
            CHECK_NEAR(apart(one, other, 0), 0, count == 1 ? 0 : wide ? 1e-6 : 1e-1);
            CHECK_NEAR(sum_of(other, 1) + wall_gain(other, 1), money, (wide ? 1e-12 : 1e-4)*money);
            CHECK_REL(wall_gain(other, 0), wall_gain(one, 0), wide ? 1e-9 : 1e-3);
            dem_slabs_destroy(slabs);
            dem_world_destroy(one);
            dem_world_destroy(other);
        }
    }
    TEST("VTP, VTK and extended XYZ files name the numbers, with one row per part of a cluster") {
        dem_world *w = mixture(1, DEM_SEARCH_GRID, 0);
        CHECK_EQ(dem_vtp_write(w, "build/tmp/reals.vtp"), DEM_OK);
        CHECK_EQ(dem_vtk_write(w, "build/tmp/reals.vtk"), DEM_OK);
        CHECK_EQ(dem_xyz_write(w, "build/tmp/reals.xyz"), DEM_OK);
        CHECK(file_has("build/tmp/reals.vtp", "Name=\"money\" NumberOfComponents=\"1\""));
        CHECK(file_has("build/tmp/reals.vtk", "SCALARS temperature double 1") ||
              file_has("build/tmp/reals.vtk", "SCALARS temperature float 1"));
        CHECK(file_has("build/tmp/reals.xyz", ":temperature:R:1:money:R:1:age:R:1:id:I:1"));
        dem_world_destroy(w);
    }
    TEST("heat flow in a chain of pressed spheres between two baths is 2 k a (400 - 300)/n with a linear profile") {
        enum { N = 12 };
        dem_body ids[N], ends[2];
        dem_world *w;
        const double a = sqrt(0.5e-3*1e-5), k = 400, mass = 2500*4/3.0*pi*1e-9, tau = mass*235/(2*k*a);
        dem_bodies all;
        int i;
        w = chain(N, ids, 1);
        ends[0] = ids[0];
        ends[1] = ids[N - 1];
        w->desc.body_reals_fn = bath;
        w->desc.body_reals_user = ends;
        w->desc.dt = (dem_real)(0.2*tau);
        CHECK_EQ(scene_step(w, 12000), DEM_OK);
        for (i = 0; i < N; i++)
            CHECK_NEAR(temperature(w, ids[i]), 400 - 100.0*i/(N - 1), wide ? 1e-9 : 3e-2);
        all = dem_bodies_get(w);
        for (i = 0; i < all.count; i++)
            if (all.slots[i] + 1 == ends[1].slot)
                CHECK_REL((double)all.rates[i]*mass*235, 2*k*a*100/(N - 1), wide ? 1e-9 : 2e-3);
        dem_world_destroy(w);
    }
    TEST("an isolated pair equilibrates as exp(-2 t/tau), tau = m c/(2 k a), to first order in dt, and conserves "
         "heat") {
        const double a = sqrt(0.5e-3*1e-5), mass = 2500*4/3.0*pi*1e-9, tau = mass*235/(2*400*a);
        double error[2];
        int fine;
        for (fine = 0; fine < 2; fine++) {
            dem_body ids[2];
            dem_world *w = chain(2, ids, 1);
            const int steps = fine ? 200 : 100;
            w->desc.dt = (dem_real)(tau/steps);
            CHECK_EQ(scene_step(w, steps), DEM_OK);
            error[fine] = (temperature(w, ids[0]) - temperature(w, ids[1]))/100/exp(-2) - 1;
            CHECK_NEAR(temperature(w, ids[0]) + temperature(w, ids[1]), 700, wide ? 1e-9 : 1e-2);
            dem_world_destroy(w);
        }
        CHECK_NEAR(error[1], -0.01, wide ? 1e-3 : 2e-3);           /* (1 - 2 h)^(1/h) = exp(-2 - 2 h) */
        if (wide) CHECK_NEAR(error[0]/error[1], 2, 0.05);
    }
    TEST("a heat step beyond stability diverges; with law_rate it is rejected with an error, and dt = 0 avoids it") {
        int count;
        dem_world *w = hot_row(2.5, 0, 1);
        CHECK_EQ(scene_step(w, 100), DEM_OK);
        CHECK(beyond(w) > 1e6);
        dem_world_destroy(w);
        w = hot_row(1.02, 1, 1);
        CHECK_EQ(dem_world_step(w, 1), DEM_ERROR_TIME_STEP);
        CHECK_STR(dem_world_error_get(w), "by desc.law_rate the numbers of body");
        CHECK_NEAR(beyond(w), 0, 1e-3);
        dem_world_destroy(w);
        w = hot_row(0.98, 1, 1);
        CHECK_EQ(scene_step(w, 100), DEM_OK);
        CHECK_NEAR(beyond(w), 0, 1e-3);
        dem_world_destroy(w);
        w = hot_row(5000, 1, 0);
        CHECK_EQ(scene_step(w, 100), DEM_OK);
        CHECK_NEAR(beyond(w), 0, 1e-3);
        scene_report_has(w, "the numbers of body");
        dem_world_destroy(w);
        for (count = 1; count <= 3; count++) {  /* sums across borders, too */
            dem_slabs_desc deal = DEM_SLABS_DESC;
            dem_slabs *slabs;
            w = hot_row(1.02, 1, 1);
            deal.count = count;
            slabs = dem_slabs_create(w, &deal);
            CHECK_EQ(dem_slabs_step(slabs, 1), DEM_ERROR_TIME_STEP);
            CHECK_STR(dem_slabs_error_get(slabs), "by desc.law_rate the numbers of body");
            dem_slabs_destroy(slabs);
            dem_world_destroy(w);
        }
    }
    TEST("a bouncing 1 mm grain charges on a metal plate as 4 pi R^2 s (1 - exp(-n A/(4 pi R^2))), and the plate "
         "loses that charge") {
        static const dem_real work[] = {DEM_R(4.2), DEM_R(4.7)};
        charge tribo = {work, DEM_R(2e-7), 0};
        dem_world_desc desc = desc_of(charge_law, &tribo, "charge", 0);
        dem_world *w;
        dem_material glass, metal;
        dem_body body;
        dem_wall plate;
        dem_wall_loads loads;
        dem_real q = 0;
        const double s = 8.8541878128e-12*(4.2 - 4.7)/2e-7, whole = 4*pi*1e-6;
        double area = 0, deepest = 0;
        int bounces = 0, touching = 0;
        desc.gravity = at(0, 0, -9.81);
        w = dem_world_create(&desc);
        glass = scene_material(w, 1e6, 1, 0, 0);
        metal = scene_material(w, 1e6, 1, 0, 0);
        plate = dem_wall_plane_add(w, metal, at(0, 0, 0), at(0, 0, 1));
        body = dem_sphere_add(w, glass, DEM_R(1e-3), at(0, 0, 0.006));
        while (bounces < 20) {
            double deep;
            CHECK_EQ(scene_step(w, 1), DEM_OK);
            deep = 1e-3 - (double)scene_state(w, body).position.z;
            if (deep > 0) { deepest = fmax(deepest, deep); touching = 1; }
            else if (touching) { area += pi*1e-3*deepest; deepest = touching = 0; bounces++; }
        }
        dem_body_reals_get(w, body, &q);
        CHECK_REL(q, whole*s*(1 - exp(-area/whole)), 1e-3);       /* each impact by Euler's steps */
        CHECK(area/whole > 0.1);
        dem_wall_loads_get(w, plate, &loads);
        CHECK_REL(loads.gained[0], -(double)q, wide ? 1e-9 : 1e-4);
        dem_world_destroy(w);
    }
    TEST("repeated contacts of two metals charge them to the field of their work functions over the gap, and conserve "
         "charge") {
        static const dem_real work[] = {DEM_R(4.2), DEM_R(4.7)};
        charge tribo = {work, DEM_R(2e-7), 0};
        dem_world_desc desc = desc_of(charge_law, &tribo, "charge", 0);
        dem_world *w;
        dem_body one, other;
        dem_real q[2] = {DEM_R(1e-13), DEM_R(1e-13)};
        const double s = 8.8541878128e-12*(4.2 - 4.7)/2e-7;
        int i;
        w = dem_world_create(&desc);
        one = dem_sphere_add(w, scene_material(w, 1e6, 1, 0, 0), DEM_R(1e-3), at(0, 0, 0));
        other = dem_sphere_add(w, scene_material(w, 1e6, 1, 0, 0), DEM_R(1e-3), at(0, 0, 0.003));
        dem_body_reals_set(w, one, q);
        dem_body_reals_set(w, other, q + 1);
        for (i = 0; i < 400; i++) {                               /* from both sides, again and again */
            dem_body_state a = scene_state(w, one), b = scene_state(w, other);
            a.position = at(0, 0, 0); b.position = at(0, 0, 0.00201);
            a.velocity = at(0, 0, 1); b.velocity = at(0, 0, -1);
            dem_body_set(w, one, &a);
            dem_body_set(w, other, &b);
            CHECK_EQ(dem_world_run(w, 1.2e-3, 0, 0), DEM_OK);
        }
        dem_body_reals_get(w, one, q);
        dem_body_reals_get(w, other, q + 1);
        CHECK_REL((double)(q[0] - q[1])/(4*pi*1e-6), s, 1e-3);
        CHECK_NEAR((double)(q[0] + q[1]), 2e-13, wide ? 1e-24 : 1e-16);
        dem_world_destroy(w);
    }
    TEST("a force field reads the numbers of a grain, v = q E t/m; the report says when no law gives rates") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *w;
        dem_body body;
        dem_real q = DEM_R(2e-9);
        const double mass = 2500*4/3.0*pi*1e-9;
        desc.body_reals = "charge";
        desc.body_force = electric;
        desc.dt = DEM_R(1e-5);
        w = dem_world_create(&desc);
        body = dem_sphere_add(w, scene_material(w, 1e6, 1, 0, 0), DEM_R(1e-3), at(0, 0, 0));
        CHECK_EQ(dem_body_reals_set(w, body, &q), DEM_OK);
        CHECK_EQ(scene_step(w, 1000), DEM_OK);
        CHECK_REL(scene_state(w, body).velocity.x, 2e-9*1000*0.01/mass, wide ? 1e-12 : 1e-4);
        scene_report_has(w, "charge: constant; no law gives rates");
        dem_world_destroy(w);
    }
    return test_end();
}
