/* What contacts remember, from outside: seen, counted and set one by one (dem_contacts_each), bonds made (dem_bonds_make),
   drawn as lines, up to 16 reals of it, on the whole road: sorting, new lists, checkpoints, slabs. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const int wide = sizeof(dem_real) == sizeof(double);
static const double R = 1e-3, range = 4e-4;

/* --- links: made at touch, broken at a gap of half the range; each event is counted by grain a --- */
static void link_law(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const int there = memory[15] > 0;
    const int will = c->overlap > 0 || (there && c->overlap > -DEM_R(0.5)*c->range);
    if (c->overlap > 0) f->normal = 500*c->overlap;
    if (!(c->dt > 0) || will == there) return;
    memory[15] = (dem_real)will;
    if (!c->wall) c->who.rate_a[will ? 0 : 1] += 1/c->dt;
}
/* A gas of spheres, or of spheres and ellipsoids, in a periodic box. */
static dem_world *gas(int shaped, int threads) {
    dem_world_desc desc = DEM_WORLD_DESC;
    const dem_box room = box_of(0, 0, 0, 0.024, 0.02, 0.02);
    dem_world *w;
    dem_material m;
    uint64_t seed = 5;
    int i;
    desc.law = link_law;
    desc.law_memory = 16;
    desc.law_memory_names = "a0 a1 a2 a3 a4 a5 a6 a7 a8 a9 a10 a11 a12 a13 a14 linked";
    desc.law_stiffness = 500;
    desc.law_range = (dem_real)range;
    desc.law_who = 1;
    desc.body_reals = "made broken";
    desc.threads = threads;
    desc.dt = DEM_R(1e-5);
    desc.domain = room;
    for (i = 0; i < 3; i++) desc.boundary[i] = DEM_BOUNDARY_PERIODIC;
    w = dem_world_create(&desc);
    m = scene_material(w, 1e6, 1, 0, 0);
    if (shaped)
        dem_bodies_fill(w, m, dem_shape_ellipsoid_add(w, at(1.2e-3, 9e-4, 8e-4)), dem_region_make(room), 120, 5);
    dem_spheres_fill(w, m, (dem_real)R, dem_region_make(room), shaped ? 120 : 500, 7);
    for (i = 0; i < dem_bodies_get(w).count; i++)
        scene_move(w, dem_body_id_get(w, i), scene_at(&seed, 4, -2, 4, -2, 4, -2), at(0, 0, 0));
    return w;
}
static void count_links(const dem_contact_info *c, dem_real *memory, void *user) {
    if (!c->wall) *(int *)user += memory[15] > 0;
}
static int links(dem_world *w) {
    int n = 0;
    CHECK(dem_contacts_each(w, count_links, &n) >= 0);
    return n;
}
/* Events so far. */
static double events(const dem_world *w, int which) {
    const dem_bodies all = dem_bodies_get(w);
    double sum = 0;
    int i;
    for (i = 0; i < all.count; i++)
        sum += (double)all.reals[2*i + which];
    return sum;
}

/* --- sixteen reals that only the two grains know: whoever finds others counts an error --- */
static void keeper(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const dem_contact_who *who = &c->who;
    const uint32_t lower = DEMI_MIN(who->a.slot, who->b.slot), upper = DEMI_MAX(who->a.slot, who->b.slot);
    const double sign = c->wall || who->a.slot < who->b.slot ? 1 : -1;
    int k, wrong = 0, fresh = 1;
    if (c->overlap > 0) f->normal = 500*c->overlap + DEM_R(0.02)*c->closing_speed;
    for (k = 0; k < 16; k++) fresh &= !(memory[k] < 0) && !(memory[k] > 0);
    for (k = 0; k < 16; k++) {              /* the first six: two vectors, which turn round with a and b */
        const double x = (k < 6 ? sign : 1)*(1 + lower + 1000*k + 0.001*(c->wall ? 0 : upper));
        if (fresh && c->dt > 0) memory[k] = (dem_real)x;
        else wrong |= !fresh && (memory[k] < (dem_real)x || memory[k] > (dem_real)x);
    }
    if (!(c->dt > 0)) return;
    who->rate_a[0] += (dem_real)wrong/c->dt;
    who->rate_a[1] += (dem_real)fresh/c->dt;
}
static dem_world *heap(void) {
    dem_world_desc desc = DEM_WORLD_DESC;
    const dem_box room = box_of(0, 0, 0, 0.02, 0.012, 0.03);
    dem_world *w;
    dem_material m;
    desc.law = keeper;
    desc.law_memory = 16;
    desc.law_vectors = 2;
    desc.law_stiffness = 500;
    desc.law_who = 1;
    desc.law_range = DEM_R(2e-4);
    desc.body_reals = "wrong fresh";
    desc.threads = 1;
    desc.dt = DEM_R(1e-5);
    desc.gravity = at(3, 0, -9.81);
    w = dem_world_create(&desc);
    m = scene_material(w, 1e6, 0.5, 0, 0);
    dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1));
    dem_wall_plane_add(w, m, at(0, 0, 0), at(1, 0, 0));
    dem_wall_plane_add(w, m, at(0.02, 0, 0), at(-1, 0, 0));
    dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 1, 0));
    dem_wall_plane_add(w, m, at(0, 0.012, 0), at(0, -1, 0));
    dem_bodies_fill(w, m, dem_shape_ellipsoid_add(w, at(1.2e-3, 9e-4, 8e-4)), dem_region_make(room), 40, 5);
    dem_spheres_fill(w, m, (dem_real)R, dem_region_make(room), 160, 7);
    return w;
}
static double all_of(const dem_world *w, int which) {
    const dem_bodies all = dem_bodies_get(w);
    double sum = 0;
    int i;
    for (i = 0; i < all.count; i++) sum += (double)all.reals[2*i + which];
    return sum;
}

/* --- a law with friction's spring, to be set from outside --- */
static void stretch(const dem_contact_info *c, dem_real *memory, void *user) {
    (void)c;
    memory[0] = *(dem_real *)user;
    memory[1] = memory[2] = 0;
}
static void tally(const dem_contact_info *c, dem_real *memory, void *user) {
    int *n = (int *)user;
    (void)memory;
    n[c->wall ? 1 : 0]++;
}
static void join(const dem_contact_info *c, dem_real *memory, void *user) {
    (void)c; (void)user;
    memory[15] = 1;
}

/* --- coefficients: grains of nine sizes and four materials between a floor and a ceiling. The largest touch both all the
   time; the others bounce, so often during the life of a list that all rows for coefficients are used up several times. --- */
enum { BOUNCERS = 40 };
/* All of them, or number `only`. */
static dem_world *bouncers(int only, int egg) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *w;
    dem_material stuff[4];
    int k;
    desc.dt = DEM_R(2e-6);
    desc.skin = DEM_R(4e-2);
    desc.threads = 1;
    desc.gravity = at(0, 0, 0);
    w = dem_world_create(&desc);
    for (k = 0; k < 4; k++) stuff[k] = scene_material(w, 1e7*(k + 1), 0.99, 0.1*k, 0);
    dem_wall_plane_add(w, stuff[0], at(0, 0, 0), at(0, 0, 1));
    dem_wall_plane_add(w, stuff[1], at(0, 0, 3.2e-3), at(0, 0, -1));
    for (k = 0; k < BOUNCERS; k++) {
        const int squeezed = k%5 == 4;
        const double r = squeezed ? 1.601e-3 : 1e-3 + 5e-5*(k/4), x = 4e-3*k;
        const dem_vec3 from = at(x, 0, 1.6e-3);
        dem_body one;
        if (only >= 0 && k != only) continue;
        one = egg ? dem_body_add(w, stuff[k%4], dem_shape_ellipsoid_add(w, at(r, r, r)), from, dem_quat_make(1, 0, 0, 0))
                  : dem_sphere_add(w, stuff[k%4], (dem_real)r, from);
        scene_move(w, one, at(0, 0.1, squeezed ? 0 : 1 + 0.01*k), at(20, 0, 0));
    }
    return w;
}

/* --- clusters that lie flat, of four materials; all of them, or number `only` --- */
enum { PLATES = 12 };
static dem_world *plates(int only) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_cluster_desc flat = DEM_CLUSTER_DESC;
    dem_real centre[300];
    dem_material stuff[4];
    dem_shape plate;
    dem_world *w;
    int k;
    for (k = 0; k < 300; k++)
        centre[k] = k%3 == 0 ? (dem_real)(1e-3*(k/3%10)) : k%3 == 1 ? (dem_real)(1e-3*(k/30)) : 0;
    desc.dt = DEM_R(2e-6);
    desc.threads = 1;
    w = dem_world_create(&desc);
    for (k = 0; k < 4; k++) stuff[k] = scene_material(w, 1e7*(k + 1), 0.9, 0.1*k, 0);
    flat.count = 100;
    flat.positions = centre;
    flat.radius = DEM_R(1e-3);
    plate = dem_shape_cluster_add(w, &flat);
    dem_wall_plane_add(w, stuff[0], at(0, 0, 0), at(0, 0, 1));
    for (k = 0; k < PLATES; k++) {
        dem_body one;
        if (only >= 0 && k != only) continue;
        one = dem_body_add(w, stuff[k%4], plate, at(0.02*k, 0, 1.001e-3), dem_quat_make(1, 0, 0, 0));
        scene_move(w, one, at(0, 0, -0.1), at(0, 0.002*k, 0));
    }
    CHECK_EQ(dem_world_step(w, 1), DEM_OK);
    return w;
}

static void bond_one(const dem_contact_info *c, dem_real *memory, void *user) {
    (void)c; (void)user;
    memory[0] = 1;
}
static void no_law(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    (void)c; (void)memory;
    f->normal = 0;
}

/* Extremes of the angle, rad, by which a bar that lies on a fixed block oscillates about the normal on the springs of its
   friction; the block is turned by `angle` and half a turn, below all of the bar's face. */
static void twist(double angle, double *least, double *most) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_body_state s;
    dem_world *w;
    dem_material m;
    dem_body block, bar;
    int i;
    desc.gravity = at(0, 0, -9.81);
    desc.threads = 1;
    desc.dt = DEM_R(4e-6);
    w = dem_world_create(&desc);
    m = scene_material(w, 1e7, 0.5, 0.8, 0);
    block = dem_body_add(w, m, scene_box(w, 0.04, 0.04, 0.01), at(0, 0, -0.005),
                         dem_quat_about(at(0, 0, 1), (dem_real)(3.14159265358979 + angle)));
    s = scene_state(w, block);
    s.fixed = 1;
    CHECK_EQ(dem_body_set(w, block, &s), DEM_OK);
    bar = dem_body_add(w, m, scene_box(w, 0.02, 0.01, 0.01), at(0, 0, 0.00499), dem_quat_make(1, 0, 0, 0));
    CHECK_EQ(dem_world_run(w, 0.05, 0, 0), DEM_OK);
    scene_move(w, bar, at(0, 0, 0), at(0, 0, 0.3));
    *least = *most = 0;
    for (i = 0; i < 3000; i++) {
        CHECK_EQ(dem_world_step(w, 1), DEM_OK);
        s = scene_state(w, bar);
        *least = fmin(*least, 2*(double)s.orientation.z);
        *most = fmax(*most, 2*(double)s.orientation.z);
    }
    dem_world_destroy(w);
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("over 10,000 links form and break in a gas: formed less broken is the number in force at any time") {
        int shaped, part;
        for (shaped = 0; shaped < 2; shaped++) {
            dem_world *w = gas(shaped, 1), *other;
            dem_slabs_desc cut = DEM_SLABS_DESC;
            dem_slabs *slabs;
            const int steps = shaped ? 1500 : 2500;
            for (part = 0; part < 3; part++) {
                CHECK_EQ(scene_step(w, steps), DEM_OK);
                CHECK_NEAR(events(w, 0) - events(w, 1), links(w), wide ? 1e-6 : 0.05);
            }
            other = gas(shaped, 1);
            CHECK_EQ(dem_checkpoint_write(w, "build/tmp/links.dem"), DEM_OK);
            CHECK_EQ(dem_checkpoint_read(other, "build/tmp/links.dem"), DEM_OK);
            remove("build/tmp/links.dem");
            CHECK_EQ(links(other), links(w));
            CHECK_EQ(scene_step(other, steps), DEM_OK);
            CHECK_NEAR(events(other, 0) - events(other, 1), links(other), wide ? 1e-6 : 0.05);
            cut.count = 3;
            slabs = dem_slabs_create(other, &cut);
            for (part = 0; part < 3; part++) {
                CHECK_EQ(dem_slabs_step(slabs, steps), DEM_OK);
                CHECK_EQ(dem_slabs_collect(slabs, w), DEM_OK);
                CHECK_NEAR(events(w, 0) - events(w, 1), links(w), wide ? 1e-6 : 0.05);
            }
            dem_slabs_destroy(slabs);
            CHECK(events(w, 1) > (shaped ? 1000 : 10000));
            if (getenv("TEST_TABLES")) printf("%g made, %g broken, %d hold\n", events(w, 0), events(w, 1), links(w));
            dem_world_destroy(w);
            dem_world_destroy(other);
        }
    }
    TEST("sixteen reals per contact, two vectors among them, survive sorting, rebuilt lists, checkpoints and slabs") {
        dem_world *w = heap(), *other = heap();
        dem_slabs_desc cut = DEM_SLABS_DESC;
        dem_slabs *slabs;
        CHECK_EQ(scene_step(w, 6000), DEM_OK);
        CHECK(all_of(w, 1) > 1000);
        CHECK_NEAR(all_of(w, 0), 0, 0);
        CHECK_EQ(dem_checkpoint_write(w, "build/tmp/keeper.dem"), DEM_OK);
        CHECK_EQ(dem_checkpoint_read(other, "build/tmp/keeper.dem"), DEM_OK);
        remove("build/tmp/keeper.dem");
        CHECK_EQ(scene_step(other, 2000), DEM_OK);
        CHECK_NEAR(all_of(other, 0), 0, 0);
        cut.count = 3;
        slabs = dem_slabs_create(other, &cut);
        CHECK_EQ(dem_slabs_step(slabs, 4000), DEM_OK);
        CHECK_EQ(dem_slabs_collect(slabs, other), DEM_OK);
        CHECK_EQ(scene_step(other, 1000), DEM_OK);
        CHECK_NEAR(all_of(other, 0), 0, 0);
        CHECK(all_of(other, 1) > all_of(w, 1) + 100);
        dem_slabs_destroy(slabs);
        dem_world_destroy(w);
        dem_world_destroy(other);
    }
    TEST("dem_contacts_each visits every contact; a friction spring set by it acts with kt times its length; visiting "
         "changes no bit") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *w[2];
        int k, n[2] = {0, 0};
        for (k = 0; k < 2; k++) {
            dem_material m;
            desc.gravity = at(0, 0, -9.81);
            desc.dt = DEM_R(1e-5);
            w[k] = dem_world_create(&desc);
            m = scene_material(w[k], 1e6, 0.5, 0.5, 0);
            dem_wall_plane_add(w[k], m, at(0, 0, 0), at(0, 0, 1));
            dem_wall_cylinder_add(w[k], m, at(0.005, 0.005, 0), at(0, 0, 1), DEM_R(7.2e-3), 1);
            dem_spheres_fill(w[k], m, (dem_real)R, dem_region_make(box_of(0, 0, 0, 0.01, 0.01, 0.03)), 200, 3);
            CHECK_EQ(scene_step(w[k], 9000), DEM_OK);
        }
        k = dem_contacts_each(w[0], tally, n);
        CHECK_EQ(k, n[0] + n[1]);
        CHECK_EQ(dem_contacts_get(w[0], 0, 0), n[0] + n[1]);
        if (getenv("TEST_TABLES")) printf("%d contacts, %d at walls\n", n[0], n[1]);
        CHECK(n[0] > 60 && n[1] > 60);
        for (k = 0; k < 2; k++) CHECK_EQ(scene_step(w[k], 100), DEM_OK);
        CHECK(dem_world_hash_get(w[0]) == dem_world_hash_get(w[1]));
        for (k = 0; k < 2; k++) dem_world_destroy(w[k]);
        { /* one grain on a plane: 1 um of spring along x */
            dem_real along = DEM_R(1e-6);
            dem_pair pair;
            dem_body body;
            dem_material m;
            double G, kt;
            desc.gravity = at(0, 0, 0);
            w[0] = dem_world_create(&desc);
            m = scene_material(w[0], 1e6, 1, 10, 0);
            dem_wall_plane_add(w[0], m, at(0, 0, 0), at(0, 0, 1));
            body = dem_sphere_add(w[0], m, (dem_real)R, at(0, 0, 0.99*R));
            CHECK_EQ(dem_contacts_each(w[0], stretch, &along), 1);
            dem_pair_get(w[0], m, m, &pair);
            G = (double)pair.shear_eff;
            kt = 8*G*sqrt(R*0.01*R);
            dem_candidates_rebuild(w[0]);
            CHECK(dem_contacts_each(w[0], tally, n) == 1);
            CHECK_REL(fabs((double)scene_state(w[0], body).force.x), kt*1e-6, wide ? 1e-6 : 1e-3);
            dem_world_destroy(w[0]);
        }
    }
    TEST("dem_bonds_make bonds all grains nearer than the gap, fails beyond the range, and files draw bonds as named "
         "lines") {
        dem_world *w = gas(0, 1);
        const dem_bodies all = dem_bodies_get(w);
        int i, j, k, near = 0;
        FILE *file;
        static char text[4000];
        for (i = 0; i < all.count; i++)
            for (j = 0; j < i; j++) {
                double d[3], length[3] = {0.024, 0.02, 0.02}, far = 0;
                for (k = 0; k < 3; k++) {
                    d[k] = (double)(all.positions[4*i + k] - all.positions[4*j + k]);
                    d[k] -= length[k]*floor(d[k]/length[k] + 0.5);
                    far += d[k]*d[k];
                }
                near += sqrt(far) - 2*R < 3e-4;
            }
        CHECK_EQ(dem_bonds_make(w, DEM_R(3e-4), join, 0), near);
        CHECK(near > 100);
        CHECK_EQ(links(w), near);
        CHECK_EQ(dem_bonds_make(w, DEM_R(5e-4), join, 0), -1);
        CHECK_STR(dem_world_error_get(w), "at most 0.0004 m");
        CHECK_EQ(dem_contacts_each(w, 0, 0), -1);
        CHECK_EQ(dem_contacts_vtp_write(w, "build/tmp/links.vtp"), DEM_OK);
        file = fopen("build/tmp/links.vtp", "rb");
        CHECK(file != 0);
        if (file) {
            CHECK(fread(text, 1, sizeof text - 1, file) > 1000);
            fclose(file);
        }
        CHECK_STR(text, "Name=\"linked\"");
        CHECK_STR(text, "NumberOfPolys=\"0\"");
        CHECK(!strstr(text, "NumberOfLines=\"0\""));
        dem_world_destroy(w);
    }
    TEST("grains of many kinds on two walls bounce exactly as each does alone, spheres and ellipsoids") {
        int egg, k;
        for (egg = 0; egg < 2; egg++) {
            dem_world *all = bouncers(-1, egg);
            int turned = 0;
            CHECK_EQ(dem_world_step(all, 20000), DEM_OK);
            for (k = 0; k < BOUNCERS; k++) {
                dem_world *alone = bouncers(k, egg);
                dem_body_state a, b;
                const double x = 4e-3*k;
                int i;
                for (i = 0; i < BOUNCERS; i++) {        /* its order has changed */
                    a = scene_state(all, dem_body_id_get(all, i));
                    if (fabs((double)a.position.x - x) < 2e-3) break;
                }
                CHECK(i < BOUNCERS);
                CHECK_EQ(dem_world_step(alone, 20000), DEM_OK);
                b = scene_state(alone, dem_body_id_get(alone, 0));
                CHECK(!memcmp(&a.position, &b.position, sizeof a.position));
                CHECK(!memcmp(&a.velocity, &b.velocity, sizeof a.velocity));
                CHECK(!memcmp(&a.spin, &b.spin, sizeof a.spin));
                turned += a.velocity.z < 0;
                dem_world_destroy(alone);
            }
            CHECK(turned > 5 && turned < BOUNCERS - 5);
            dem_world_destroy(all);
        }
    }
    TEST("a checkpoint that is written between two steps, and a belt that changes then, leave coefficients to their contacts") {
        const char *path = "build/tmp/kept.ckpt";
        dem_world *with = bouncers(-1, 0), *without = bouncers(-1, 0);
        const dem_wall floor = {1};
        int i;
        for (i = 0; i < 10; i++) {
            CHECK_EQ(dem_world_step(with, 500), DEM_OK);
            CHECK_EQ(dem_world_step(without, 500), DEM_OK);
            CHECK_EQ(dem_checkpoint_write(with, path), DEM_OK);
            CHECK_EQ(dem_wall_surface_velocity_set(with, floor, at(0.1*i, 0, 0)), DEM_OK);
            CHECK_EQ(dem_wall_surface_velocity_set(without, floor, at(0.1*i, 0, 0)), DEM_OK);
        }
        CHECK_EQ(dem_world_step(with, 500), DEM_OK);
        CHECK_EQ(dem_world_step(without, 500), DEM_OK);
        CHECK(dem_world_hash_get(with) == dem_world_hash_get(without));
        dem_world_destroy(with);
        dem_world_destroy(without);
        remove(path);
    }
    TEST("plates of 100 spheres, which need more contacts than their list has room for, fall as each does alone") {
        dem_world *all = plates(-1);
        int i, k, moved = 0;
        const int room = all->persistent_first[DEMI_DOMAINS];
        CHECK_EQ(dem_world_step(all, 20), DEM_OK);
        CHECK(all->persistent_first[DEMI_DOMAINS] > 2*room);
        CHECK_EQ(dem_world_step(all, 780), DEM_OK);
        for (k = 0; k < PLATES; k++) {
            dem_world *alone = plates(k);
            dem_body_state a = scene_state(all, dem_body_id_get(all, 0)), b;
            for (i = 0; i < PLATES && fabs((double)a.position.x - 0.02*k) > 5e-3; i++)
                a = scene_state(all, dem_body_id_get(all, i));
            CHECK_EQ(dem_world_step(alone, 800), DEM_OK);
            b = scene_state(alone, dem_body_id_get(alone, 0));
            CHECK(!memcmp(&a.position, &b.position, sizeof a.position));
            CHECK(!memcmp(&a.velocity, &b.velocity, sizeof a.velocity));
            CHECK(!memcmp(&a.spin, &b.spin, sizeof a.spin));
            moved += a.velocity.z > 0;
            dem_world_destroy(alone);
        }
        CHECK(moved > 0);
        dem_world_destroy(all);
    }
    TEST("dem_bonds_make compares the gap with the range of the smallest parts of clusters and unions") {
        int unions;
        for (unions = 0; unions < 2; unions++) {       /* parts of 0.1 m in bodies of 0.5 m: range 0.5 (0.1 + 0.1) */
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_cluster_desc cluster = DEM_CLUSTER_DESC;
            dem_real x[6] = {DEM_R(-0.4), 0, 0, DEM_R(0.4), 0, 0};
            dem_shape shape, two[2];
            dem_material m;
            dem_world *w;
            desc.law = no_law;
            desc.law_range_radii = DEM_R(0.5);
            desc.law_memory = 1;
            desc.law_stiffness = DEM_R(1e5);
            desc.dt = DEM_R(1e-5);
            w = dem_world_create(&desc);
            m = scene_material(w, 1e7, 1, 0, 0);
            cluster.count = 2;
            cluster.positions = x;
            cluster.radius = DEM_R(0.1);
            two[0] = two[1] = dem_shape_ellipsoid_add(w, at(0.1, 0.1, 0.1));
            shape = unions ? dem_shape_union_add(w, 2, two, x, 0) : dem_shape_cluster_add(w, &cluster);
            dem_body_add(w, m, shape, at(0, 0, 0), dem_quat_make(1, 0, 0, 0));
            dem_body_add(w, m, shape, at(0, 0.28, 0), dem_quat_make(1, 0, 0, 0));      /* gaps of 0.08 m */
            CHECK_EQ(dem_bonds_make(w, DEM_R(0.12), bond_one, 0), -1);
            CHECK_STR(dem_world_error_get(w), "at most 0.1 m");
            CHECK_EQ(dem_bonds_make(w, DEM_R(0.09), bond_one, 0), 2);
            dem_world_destroy(w);
        }
    }
    TEST("a bar twists on its friction springs alike however the block beneath it is turned") {
        double least, most, low, high;
        int i;
        twist(0.3, &low, &high);
        CHECK(low < -1e-4 && high > 2e-4);
        for (i = -1; i < 3; i++) {
            twist(i*5e-5, &least, &most);
            CHECK_NEAR(least, low, (wide ? 1e-3 : 0.1)*(high - low));
            CHECK_NEAR(most, high, (wide ? 1e-3 : 0.1)*(high - low));
        }
    }
    return test_end();
}
