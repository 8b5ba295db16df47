/* Averages: mixing and segregation of two components, variances of cells and bodies, residence times, tables. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

/* n^3 touching spheres on a cubic lattice, of material 1; *other: material 2. */
enum { EDGE = 8, ALL = EDGE*EDGE*EDGE };
static dem_world *lattice(dem_material *other) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material m;
    int i;
    desc.domain = box_of(0, 0, 0, EDGE, EDGE, EDGE);
    world = dem_world_create(&desc);
    m = scene_material(world, 1e6, 0.9, 0.5, 0);
    *other = scene_material(world, 1e6, 0.9, 0.5, 0);
    for (i = 0; i < ALL; i++)
        dem_sphere_add(world, m, DEM_R(0.501), at(i%EDGE + 0.5, i/EDGE%EDGE + 0.5, i/EDGE/EDGE + 0.5));
    CHECK_EQ(dem_candidates_rebuild(world), DEM_OK);
    return world;
}
static dem_mixing_desc lattice_desc(dem_material part, int cells) {
    dem_mixing_desc d = DEM_MIXING_DESC;
    d.box = box_of(0, 0, 0, EDGE, EDGE, EDGE);
    d.cells[0] = d.cells[1] = d.cells[2] = cells;
    d.material = part;
    return d;
}
/* Grains of two materials and sizes fly through a periodic box, a feed adds some, an outlet takes some and another
   counts; a field with averages of bodies and, if not in slabs, variances. kind: 0 springs, 1 impulses, 2 ellipsoids. */
enum { SPRINGS, IMPULSES, ELLIPSOIDS };
static dem_world *busy(int kind, int variance, int threads, dem_outlet *out, dem_field *field) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_feed_desc feed = DEM_FEED_DESC;
    dem_outlet_desc outlet = DEM_OUTLET_DESC;
    dem_field_desc f = DEM_FIELD_DESC;
    dem_world *world;
    dem_material m;
    uint64_t random = 5;
    int i;
    desc.domain = box_of(0, 0, 0, 1, 0.5, 0.5);
    desc.boundary[0] = desc.boundary[1] = desc.boundary[2] = DEM_BOUNDARY_PERIODIC;
    desc.gravity = at(0.5, 0, 0);
    desc.dt = DEM_R(2e-4);
    desc.threads = threads;
    desc.allow_large_dt = 1;
    if (kind == IMPULSES) desc.response = DEM_RESPONSE_IMPULSES;
    world = dem_world_create(&desc);
    m = scene_material(world, 1e6, 0.8, 0.4, 0);
    for (i = 0; i < 160; i++) {
        const dem_vec3 x = at(0.05 + 0.1*(i%10), 0.0625 + 0.125*(i/10%4), 0.0625 + 0.125*(i/40));
        dem_body b;
        if (kind == ELLIPSOIDS && i%2) b = dem_body_add(world, m, dem_shape_ellipsoid_add(world, at(0.03, 0.02, 0.02)), x, dem_quat_make(1, 0, 0, 0));
        else b = dem_sphere_add(world, m, i%2 ? DEM_R(0.03) : DEM_R(0.02), x);
        scene_move(world, b, scene_at(&random, 4, -1, 4, -2, 4, -2), scene_at(&random, 9, -4, 9, -4, 9, -4));
    }
    feed.material = m;
    feed.class_count = 1;
    feed.radius[0] = DEM_R(0.01);
    feed.amount[0] = 1;
    feed.rate = 300;
    feed.box = box_of(0.1, 0.1, 0.1, 0.4, 0.4, 0.4);
    dem_feed_add(world, &feed);
    outlet.box = box_of(0.9, 0, 0, 0.95, 0.5, 0.5);
    outlet.residence_bin = 0.01;
    outlet.class_count = 3;
    outlet.radius[0] = DEM_R(0.01); outlet.radius[1] = DEM_R(0.02); outlet.radius[2] = DEM_R(0.03);
    *out = dem_outlet_add(world, &outlet);
    outlet.box = box_of(0.5, 0, 0, 0.6, 0.5, 0.5);
    outlet.keep = 1;
    dem_outlet_add(world, &outlet);
    f.box = box_of(0, 0, 0, 1, 0.5, 0.5);
    f.cells[0] = 4; f.cells[1] = 2; f.cells[2] = 1;
    f.interval = 1e-9;
    f.stress = kind != IMPULSES;
    f.variance = variance;
    f.bodies = 1;
    *field = dem_field_add(world, &f);
    CHECK_EQ(scene_step(world, 20), DEM_OK);
    return world;
}
/* Digest of the averages, in the order of bodies. */
static uint64_t digest(const dem_world *world, dem_outlet out, dem_field field) {
    dem_outlet_state state;
    dem_field_cell cell;
    uint64_t h = dem_world_hash_get(world);
    int i;
    for (i = 0; i < world->bodies.slot_count; i++) {
        dem_body_means m;
        const int b = world->bodies.slot_index[i];
        if (b < 0 || dem_body_means_get(world, dem_body_id_get(world, b), &m) != DEM_OK) continue;
        h = demi_hash(h, &m, sizeof m);
    }
    memset(&state, 0, sizeof state);
    dem_outlet_get(world, out, &state);
    h = demi_hash(h, state.residence, sizeof state.residence);
    h = demi_hash(h, state.residence_count, sizeof state.residence_count);
    for (i = 0; i < 8; i++)
        if (dem_field_cell_get(world, field, i%4, i/4, 0, &cell) == DEM_OK) h = demi_hash(h, &cell, sizeof cell);
    return h;
}
/* Counts the lines of a file, and the words of its first line; lines < 0: there is none. */
static int lines_of(const char *path, int *words) {
    FILE *f = fopen(path, "rb");
    int c, lines = 0, commas = 0;
    if (!f) return -1;
    while ((c = fgetc(f)) != EOF) {
        if (c == ',' && !lines) commas++;
        lines += c == '\n';
    }
    fclose(f);
    *words = commas + 1;
    return lines;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("a segregated packing has Lacey's index 0 and full segregation, also with cells that do not fit it") {
        dem_material other;
        dem_world *world = lattice(&other);
        dem_mixing_desc d = lattice_desc(other, 4);
        dem_mixing m;
        int i;
        for (i = 0; i < ALL; i++)              /* slots: the upper half is the component */
            world->bodies.material[world->bodies.slot_index[i]] = (int32_t)(i >= ALL/2 ? other.id : 1);
        CHECK_EQ(dem_mixing_get(world, &d, &m), DEM_OK);
        CHECK_EQ(m.grains, ALL);
        CHECK_EQ(m.part, ALL/2);
        CHECK_EQ(m.cells, 64);
        CHECK_NEAR(m.lacey, 0, 1e-14);
        CHECK_NEAR(m.kramer, 0, 1e-14);
        CHECK_NEAR(m.variance_segregated, 0.25, 1e-15);
        CHECK_NEAR(m.variance_random, 0.25*63/511, 1e-15);
        CHECK_NEAR(m.segregation[2], 1, 1e-14);
        CHECK_NEAR(m.segregation[0], 0, 1e-14);     /* all ties are between equal numbers of both */
        CHECK(m.segregation_radial != m.segregation_radial);
        CHECK_EQ(m.contacts, 3*EDGE*EDGE*(EDGE - 1));
        /* 64 of 1344 contacts cross the border; 2 x 256 x 256/(512 x 511) of all would in a random mixture */
        CHECK_NEAR(m.contact_segregation, 1 - (64.0/1344)/(2.0*256*256/(512.0*511)), 1e-14);
        d.cells[2] = 3;                        /* the middle layer of cells holds 2 layers of grains of 8/3: both kinds */
        CHECK_EQ(dem_mixing_get(world, &d, &m), DEM_OK);
        CHECK_NEAR(m.variance, 0.25*0.75, 1e-14);   /* 6 of 8 layers are in pure cells, 2 in cells of one half */
        /* the shell of a drum: grains farther than 2.5 from the axis */
        d = lattice_desc(other, 4);
        d.centre = at(4, 4, 0);
        d.axis = at(0, 0, -2);
        for (i = 0; i < ALL; i++)
            world->bodies.material[world->bodies.slot_index[i]] =
                (int32_t)(hypot(i%EDGE - 3.5, i/EDGE%EDGE - 3.5) > 2.5 ? other.id : 1);
        CHECK_EQ(dem_mixing_get(world, &d, &m), DEM_OK);
        CHECK_NEAR(m.segregation_radial, 1, 1e-14);
        CHECK_NEAR(m.segregation[2], 0, 1e-14);
        /* one component alone, one cell, cells of single grains: no index */
        d.radius_min = 1;
        CHECK_EQ(dem_mixing_get(world, &d, &m), DEM_OK);
        CHECK(m.part == 0 && m.lacey != m.lacey && m.segregation[2] != m.segregation[2]);
        d = lattice_desc(other, 1);
        CHECK_EQ(dem_mixing_get(world, &d, &m), DEM_OK);
        CHECK(m.lacey != m.lacey && m.segregation[2] == m.segregation[2]);
        d = lattice_desc(other, EDGE);
        CHECK_EQ(dem_mixing_get(world, &d, &m), DEM_OK);
        CHECK(m.cells == ALL && m.lacey != m.lacey);
        dem_world_destroy(world);
    }

    TEST("random packings have Lacey's index 1, no segregation, and its variance over random mixtures") {
        enum { DEALS = 400, PART = 128 };
        dem_material other;
        dem_world *world = lattice(&other);
        dem_mixing_desc d = lattice_desc(other, 3);
        double sum[3] = {0, 0, 0}, square[3] = {0, 0, 0};
        const double exact = (ALL + 1)/(3.0*PART*(ALL - PART));
        uint64_t random = 7;
        int deal, i, k;
        for (i = 0; i < ALL; i++) world->bodies.material[i] = (int32_t)(i < PART ? other.id : 1);
        for (deal = 0; deal < DEALS; deal++) {
            dem_mixing m;
            for (i = ALL - 1; i > 0; i--) {
                const int j = (int)(scene_random(&random)*(i + 1));
                const int32_t was = world->bodies.material[i];
                world->bodies.material[i] = world->bodies.material[j];
                world->bodies.material[j] = was;
            }
            CHECK_EQ(dem_mixing_get(world, &d, &m), DEM_OK);
            for (k = 0; k < 3; k++) {
                const double x = k == 0 ? m.lacey : k == 1 ? m.segregation[0] : m.contact_segregation;
                sum[k] += x/DEALS;
                square[k] += x*x/DEALS;
            }
        }
        for (k = 0; k < 3; k++) {              /* within 4 standard errors */
            CHECK_NEAR(sum[k], k == 0, 4*sqrt((square[k] - sum[k]*sum[k])/DEALS));
            CHECK(square[k] - sum[k]*sum[k] < 0.01);
        }
        CHECK_REL(square[1], exact, 4*sqrt(2.0/DEALS));
        dem_world_destroy(world);
    }

    TEST("the variance of a random mixture is the mean over all deals of grains to cells of any size") {
        dem_world *world = dem_world_create(&DEM_WORLD_DESC);
        const double x[6] = {0.5, 1.2, 1.5, 2.1, 2.5, 2.9};     /* cells of 1, 2 and 3 grains */
        dem_mixing_desc d = DEM_MIXING_DESC;
        dem_mixing m;
        double mean = 0, lacey = 0;
        int a, b, i;
        scene_material(world, 1e6, 0.9, 0.5, 0);
        d.material = scene_material(world, 1e6, 0.9, 0.5, 0);
        for (i = 0; i < 6; i++) dem_sphere_add(world, d.material, DEM_R(0.01), at(x[i], 0, 0));
        d.box = box_of(0, -1, -1, 3, 1, 1);
        d.cells[0] = 3; d.cells[1] = d.cells[2] = 1;
        for (a = 0; a < 6; a++)
            for (b = 0; b < a; b++) {
                for (i = 0; i < 6; i++) world->bodies.material[i] = (int32_t)(i == a || i == b ? d.material.id : 1);
                CHECK_EQ(dem_mixing_get(world, &d, &m), DEM_OK);
                mean += m.variance/15;
                lacey += m.lacey/15;
            }
        CHECK_REL(m.variance_random, mean, 1e-14);
        CHECK_REL(lacey, 1, 1e-13);
        CHECK_EQ(m.contacts, -1);
        dem_world_destroy(world);
    }

    TEST("variances of cells and bodies are those of the samples, for springs, impulses and ellipsoids") {
        int kind;
        for (kind = SPRINGS; kind <= ELLIPSOIDS; kind++) {
            dem_outlet out;
            dem_field field;
            dem_world *world = busy(kind, 1, 1, &out, &field);
            double sum[8][6], square[8][6], v[2][9];
            const dem_body who = dem_body_id_get(world, 40);
            dem_body_means means;
            dem_field_cell c;
            int step, i, k, n = 0;
            memset(sum, 0, sizeof sum);
            memset(square, 0, sizeof square);
            memset(v, 0, sizeof v);
            CHECK_EQ(dem_field_reset(world, field), DEM_OK);
            for (step = 0; step < 300; step++) {
                double now[8][6];               /* volume fraction, mass, momentum, grains */
                dem_body_state s = scene_state(world, who);
                memset(now, 0, sizeof now);
                if (scene_step(world, 1) != DEM_OK) break;
                n++;
                for (i = 0; i < world->bodies.count; i++) {
                    const dem_body_state b = scene_state(world, dem_body_id_get(world, i));
                    const dem_vec3 x = b.position;
                    const int cx = (int)floor((double)x.x*4), cy = (int)floor((double)x.y*4);
                    double *to = now[((cx%4) + 4)%4 + 4*(((cy%2) + 2)%2)];
                    to[0] += (double)b.mass/2500*32;
                    to[1] += (double)b.mass;
                    to[2] += (double)(b.mass*b.velocity.x);
                    to[3] += (double)(b.mass*b.velocity.y);
                    to[4] += (double)(b.mass*b.velocity.z);
                    to[5]++;
                }
                for (i = 0; i < 8; i++)
                    for (k = 0; k < 6; k++) {
                        sum[i][k] += now[i][k];
                        square[i][k] += now[i][k]*now[i][k]/(k > 1 && k < 5 ? (now[i][1] > 0 ? now[i][1] : 1) : 1);
                    }
                s = scene_state(world, who);
                for (k = 0; k < 9; k++) {
                    const dem_vec3 *x = k < 3 ? &s.velocity : k < 6 ? &s.spin : &s.force;
                    const double one = (double)(k%3 == 0 ? x->x : k%3 == 1 ? x->y : x->z);
                    v[0][k] += one;
                    v[1][k] += one*one;
                }
            }
            CHECK_EQ(n, 300);
            for (i = 0; i < 8; i++) {
                CHECK_EQ(dem_field_cell_get(world, field, i%4, i/4, 0, &c), DEM_OK);
                CHECK(c.grains_variance > 0.05 && c.velocity_variance[0] > 1e-3);
                CHECK_REL(c.grains_variance, square[i][5]/n - sum[i][5]*sum[i][5]/n/n, 1e-9);
                CHECK_NEAR(c.solid_variance, square[i][0]/n - sum[i][0]*sum[i][0]/n/n, 1e-5*square[i][0]/n);
                CHECK_NEAR(c.density_variance, (square[i][1]/n - sum[i][1]*sum[i][1]/n/n)*32*32, 1e-2*square[i][1]/n);
                CHECK(c.solid_variance > 1e-3*square[i][0]/n);
                for (k = 0; k < 3; k++)
                    CHECK_REL(c.velocity_variance[k], square[i][2 + k]/sum[i][1] - pow(sum[i][2 + k]/sum[i][1], 2), 1e-4);
            }
            CHECK_EQ(dem_body_means_get(world, who, &means), DEM_OK);
            CHECK_EQ(means.samples, 300);
            for (k = 0; k < 9; k++) {
                const double *mean = k < 3 ? means.velocity : k < 6 ? means.spin : means.force;
                const double *var = k < 3 ? means.velocity_variance : k < 6 ? means.spin_variance : means.force_variance;
                CHECK_REL(mean[k%3], v[0][k]/n, 1e-5);
                CHECK_NEAR(var[k%3], v[1][k]/n - v[0][k]*v[0][k]/n/n, 1e-5*v[1][k]/n + 1e-12);
            }
            dem_world_destroy(world);
        }
    }

    TEST("averages and residence times are the same after a checkpoint, with threads and, to round-off, in slabs") {
        int kind, slabbed;
        for (kind = SPRINGS; kind <= ELLIPSOIDS; kind++) {
            dem_outlet out, out2;
            dem_field field, field2;
            dem_world *one = busy(kind, 1, 1, &out, &field), *two = busy(kind, 1, 3, &out2, &field2);
            CHECK_EQ(dem_checkpoint_write(one, "build/tmp/averages.ckpt"), DEM_OK);
            CHECK_EQ(scene_step(two, 40), DEM_OK);
            CHECK_EQ(dem_checkpoint_read(two, "build/tmp/averages.ckpt"), DEM_OK);
            CHECK_EQ(scene_step(one, 300), DEM_OK);
            CHECK_EQ(scene_step(two, 300), DEM_OK);
            CHECK(digest(one, out, field) == digest(two, out2, field2));
            dem_world_destroy(one);
            dem_world_destroy(two);
        }
        for (slabbed = 0; slabbed < 2; slabbed++) {
            dem_outlet out, out2;
            dem_field field, field2;
            dem_world *one = busy(SPRINGS, 0, 1, &out, &field), *two = busy(SPRINGS, slabbed, 1, &out2, &field2);
            dem_slabs_desc desc = DEM_SLABS_DESC;
            dem_slabs *slabs;
            dem_outlet_state a, b;
            int i, same = 0, both = 0;
            desc.count = 3;
            slabs = dem_slabs_create(two, &desc);
            CHECK((slabs != 0) == !slabbed);
            if (slabbed) CHECK_STR(dem_world_error_get(two), "field 1 has variance 1");
            if (slabs) {
                CHECK_EQ(dem_slabs_step(slabs, 400), DEM_OK);
                CHECK_EQ(dem_slabs_collect(slabs, two), DEM_OK);
                CHECK_EQ(scene_step(one, 400), DEM_OK);
                for (i = 0; i < 160; i++) {                /* slabs insert fed grains at other places */
                    const int p = one->bodies.slot_index[i], q = two->bodies.slot_index[i];
                    dem_body_means m, n;
                    if (p < 0 || q < 0) continue;
                    CHECK_EQ(dem_body_means_get(one, dem_body_id_get(one, p), &m), DEM_OK);
                    CHECK_EQ(dem_body_means_get(two, dem_body_id_get(two, q), &n), DEM_OK);
                    both++;
                    same += m.samples == n.samples && fabs(m.velocity[0] - n.velocity[0]) < 1e-3 &&
                        fabs(one->bodies.born[p] - two->bodies.born[q]) < 1e-12;
                }
                CHECK(both > 100 && same == both);
                dem_outlet_get(one, out, &a);
                dem_outlet_get(two, out2, &b);
                CHECK(a.total > 10);
                CHECK_NEAR((double)b.total, (double)a.total, 2);
                CHECK_REL(a.residence[2]/(double)a.count[2], b.residence[2]/(double)b.count[2], 0.05);
            }
            dem_slabs_destroy(slabs);
            dem_world_destroy(one);
            dem_world_destroy(two);
        }
    }

    TEST("in a steady stream the mean residence time is length over speed, and holdup over flow, for each class") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_feed_desc feed = DEM_FEED_DESC;
        dem_outlet_desc outlet = DEM_OUTLET_DESC;
        dem_outlet_state s;
        dem_outlet out[2];
        dem_world *world;
        dem_material m[2];
        const double dt = 2e-3, late = 64*dt;      /* an outlet acts at least every 64 steps */
        double sum = 0, all = 0;
        int k, step;
        desc.domain = box_of(-1, -0.5, -0.5, 3, 0.5, 0.5);
        desc.dt = (dem_real)dt;
        desc.allow_large_dt = 1;
        world = dem_world_create(&desc);
        for (k = 0; k < 2; k++) {                   /* materials of two speeds, side by side */
            m[k] = scene_material(world, 1e6, 0.9, 0, 0);
            feed.material = m[k];
            feed.class_count = 1;
            feed.radius[0] = k ? DEM_R(0.02) : DEM_R(0.01);
            feed.amount[0] = 1;
            feed.rate = 50;
            feed.box = box_of(0, k ? 0.1 : -0.4, -0.4, 0.001, k ? 0.4 : -0.1, 0.4);
            feed.velocity = at(k ? 0.5 : 1, 0, 0);
            dem_feed_add(world, &feed);
        }
        outlet.box = box_of(1, -9, -9, 9, 9, 9);
        outlet.residence_bin = 0.3;
        outlet.class_count = 2;
        outlet.radius[0] = DEM_R(0.01); outlet.radius[1] = DEM_R(0.02);
        out[0] = dem_outlet_add(world, &outlet);
        outlet.box = box_of(0.5, -9, -9, 0.9, 9, 9);   /* counts on the way, one material only */
        outlet.keep = 1;
        outlet.material = m[1];
        out[1] = dem_outlet_add(world, &outlet);
        CHECK_EQ(scene_step(world, 1500), DEM_OK);
        CHECK_EQ(dem_outlet_reset(world, out[0]), DEM_OK);
        CHECK_EQ(dem_outlet_reset(world, out[1]), DEM_OK);
        for (step = 0; step < 2000; step += 25) {
            CHECK_EQ(scene_step(world, 25), DEM_OK);
            sum += world->bodies.count/80.0;
        }
        CHECK_EQ(dem_outlet_get(world, out[0], &s), DEM_OK);
        CHECK(s.count[0] > 190 && s.count[1] > 190);
        for (k = 0; k < 2; k++) {
            const double n = (double)s.count[k], mean = s.residence[k]/n, length = k ? 2 : 1;
            CHECK_NEAR(mean, length + late/2, late/2 + 2*dt);
            CHECK(s.residence_square[k]/n - mean*mean <= late*late/4 + 1e-9);
            all += s.residence[k];
        }
        /* Little's law: the number inside is the rate times the mean residence time */
        CHECK_REL(sum, all/(double)s.total*100, 0.02);
        CHECK_EQ(s.residence_count[3], s.count[0]);
        CHECK_EQ(s.residence_count[6], s.count[1]);
        CHECK_EQ(dem_outlet_get(world, out[1], &s), DEM_OK);
        CHECK_NEAR(s.residence[1]/(double)s.count[1], 1 + late/2, late/2 + 2*dt);
        CHECK_EQ(s.count[0], 0);
        CHECK_EQ(dem_outlet_residence_csv_write(world, out[0], "build/tmp/averages_residence.csv"), DEM_OK);
        CHECK_EQ(lines_of("build/tmp/averages_residence.csv", &k), 8);
        CHECK_EQ(k, 4);
        dem_world_destroy(world);
    }

    TEST("scheduled outputs write tables of bodies, contacts, fields, walls and mixing that can be read back") {
        dem_outlet out;
        dem_field field;
        dem_world *world = busy(SPRINGS, 1, 1, &out, &field);
        dem_output_desc d = DEM_OUTPUT_DESC;
        static const dem_output_kind kinds[4] = {DEM_OUTPUT_WALLS, DEM_OUTPUT_BODIES_CSV, DEM_OUTPUT_CONTACTS_CSV,
                                                 DEM_OUTPUT_FIELD_CSV};
        static const char *const paths[4] = {"build/tmp/averages_w_#.vtp", "build/tmp/averages_b_#.csv",
                                             "build/tmp/averages_c_#.csv", "build/tmp/averages_f_#.csv"};
        dem_grains g;
        double force = 0, x;
        FILE *f;
        char line[2000];
        int k, words = 0, contacts;
        d.interval = 0.02;
        CHECK_EQ(dem_output_add(world, &d).id, 0);   /* no function */
        for (k = 0; k < 4; k++) {
            d.kind = kinds[k];
            d.path = paths[k];
            if (k == 3) CHECK_EQ(dem_output_add(world, &d).id, 0);   /* no field */
            if (k == 3) d.field = field;
            CHECK(dem_output_add(world, &d).id > 0);
        }
        d.kind = DEM_OUTPUT_CSV;
        d.path = "build/tmp/averages_mix.csv";
        d.mixing.cells[0] = 5;
        CHECK_EQ(dem_output_add(world, &d).id, 0);   /* no cells along y and z, no box */
        CHECK_STR(dem_world_error_get(world), "dem_output_add: cells");
        d.mixing.cells[1] = d.mixing.cells[2] = 1;
        d.mixing.box = box_of(0, 0, 0, 1, 0.5, 0.5);
        CHECK_EQ(dem_output_add(world, &d).id, 0);
        CHECK_STR(dem_world_error_get(world), "every grain is of the component");
        d.mixing.radius_min = DEM_R(0.025);
        CHECK(dem_output_add(world, &d).id > 0);
        CHECK_EQ(dem_world_run(world, 0.1, 0, 0), DEM_OK);
        CHECK_EQ(dem_bodies_csv_write(world, "build/tmp/averages_b.csv"), DEM_OK);
        CHECK_EQ(dem_grains_read(world, "build/tmp/averages_b.csv", &g), DEM_OK);
        CHECK_EQ(g.count, world->bodies.count);
        for (k = 0; k < g.count; k++) {
            CHECK_NEAR((double)g.velocities[3*k], (double)world->bodies.vel[4*k], 1e-7);
            CHECK_NEAR((double)g.radii[k], (double)world->bodies.pos[4*k + 3], 1e-8);
        }
        dem_grains_free(world, &g);
        contacts = dem_contacts_get(world, 0, 0);
        CHECK(contacts > 0);
        CHECK_EQ(dem_contacts_csv_write(world, "build/tmp/averages_c.csv"), DEM_OK);
        CHECK_EQ(lines_of("build/tmp/averages_c.csv", &words), contacts + 1);
        CHECK_EQ(words, 13);
        f = fopen("build/tmp/averages_c.csv", "rb");
        while (f && fgets(line, sizeof line, f))
            if (sscanf(line, "%*d,%*d,%*d,%*f,%*f,%*f,%*f,%*f,%*f,%*f,%lf", &x) == 1) force += fabs(x);
        if (f) fclose(f);
        CHECK(force > 0);
        CHECK_EQ(lines_of("build/tmp/averages_f_5.csv", &words), 9);
        CHECK_EQ(words, 9 + 8 + 6);
        CHECK(lines_of("build/tmp/averages_b_4.csv", &words) > 100);
        CHECK_EQ(words, 12 + 19);
        CHECK(lines_of("build/tmp/averages_c_3.csv", &words) > 0);
        CHECK(lines_of("build/tmp/averages_w_2.vtp", &words) > 0);
        k = lines_of("build/tmp/averages_mix.csv", &words);
        CHECK(k >= 5 && k <= 7);
        CHECK_EQ(words, 12);
        dem_world_destroy(world);
    }
    return test_end();
}
