/* Distributions of size: shares of mass and of number, drawn, in equal steps, in classes for a feed, filled in. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static dem_world *empty(int planar) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.planar = planar;
    return dem_world_create(&desc);
}
static dem_sizes sieves(void) {
    dem_sizes d = DEM_SIZES;
    const double mm[] = {0.5, 1, 2, 4}, pass[] = {0.1, 0.3, 0.8, 1};
    int k;
    d.kind = DEM_SIZES_SIEVE_CURVE;
    d.count = 4;
    for (k = 0; k < 4; k++) { d.radius[k] = (dem_real)(mm[k]*1e-3); d.passing[k] = pass[k]; }
    return d;
}
/* Share of the mass (power 3 or 2) or number (0) of some radii that is finer than r. */
static double finer(const dem_real *radii, int count, int power, double r) {
    double all = 0, part = 0;
    int i;
    for (i = 0; i < count; i++) {
        const double m = power == 3 ? (double)(radii[i]*radii[i]*radii[i]) : power == 2 ? (double)(radii[i]*radii[i]) : 1;
        all += m;
        if ((double)radii[i] < r) part += m;
    }
    return part/all;
}

int main(int argc, char **argv) {
    static dem_real radii[200000];
    const int many = 200000;
    test_begin(argc, argv);

    TEST("drawn radii have the fractions by mass or number of their distribution, for discs too, at random and in "
         "equal steps") {
        int kind, by_count, planar, seed, i;
        for (kind = 0; kind < 4; kind++)
            for (by_count = 0; by_count < 2; by_count++)
                for (planar = 0; planar < 2; planar++)
                    for (seed = 0; seed < 2; seed++) {
                        dem_world *world = empty(planar);
                        dem_sizes d = sieves();
                        double lo, hi;
                        d.by_count = by_count;
                        d.kind = (dem_sizes_kind)kind;
                        if (kind < 3) { d.min = DEM_R(0.6e-3); d.max = DEM_R(3e-3); }
                        d.median = DEM_R(1.5e-3);
                        d.spread = 0.4;
                        d.scale = DEM_R(1.7e-3);
                        d.modulus = 3;
                        lo = kind < 3 ? 0.6e-3 : 0.5e-3;
                        hi = kind < 3 ? 3e-3 : 4e-3;
                        CHECK_EQ(dem_sizes_draw(world, &d, many, (uint64_t)seed*7, radii), DEM_OK);
                        for (i = 1; i < 10; i++) {
                            const double r = lo + (hi - lo)*i/10;
                            /* by chance: 5 standard errors of the mass share, whose coarse tail is few grains */
                            CHECK_NEAR(finer(radii, many, by_count ? 0 : planar ? 2 : 3, r), dem_sizes_finer_get(world, &d, (dem_real)r),
                                       seed ? 0.015 : 2e-3);
                        }
                        for (i = 0; i < many; i++) if ((double)radii[i] < lo*(1 - 1e-6) || (double)radii[i] > hi*(1 + 1e-6)) break;
                        CHECK_EQ(i, many);
                        if (!seed) for (i = 1; i < many; i++) if (radii[i] < radii[i - 1]) { CHECK(0); break; }
                        if (test_now.wrong) printf("        kind %d by_count %d planar %d seed %d\n", kind, by_count, planar, seed);
                        dem_world_destroy(world);
                    }
    }

    TEST("closed forms: log-normal median, 1 - 1/e of a Weibull below its scale, and the passing of a sieve curve") {
        dem_world *world = empty(0);
        dem_sizes d = DEM_SIZES;
        int i;
        d.kind = DEM_SIZES_LOGNORMAL;
        d.median = DEM_R(0.001);
        d.spread = 0.3;
        CHECK_NEAR(dem_sizes_finer_get(world, &d, d.median), 0.5, 1e-6);
        CHECK_NEAR(dem_sizes_finer_get(world, &d, (dem_real)(0.001*exp(0.3))), 0.8413447460685429, 1e-6);
        /* mean of the number when the shares are of the mass: median e^(-2.5 spread^2) (Hatch and Choate 1929) */
        CHECK_EQ(dem_sizes_draw(world, &d, many, 0, radii), DEM_OK);
        {
            double sum = 0;
            for (i = 0; i < many; i++) sum += (double)radii[i]/many;
            CHECK_REL(sum, 0.001*exp(-2.5*0.09), 1e-3);
        }
        memset(&d, 0, sizeof d);
        d.kind = DEM_SIZES_WEIBULL;
        d.scale = DEM_R(0.002);
        d.modulus = 2.5;
        d.min = DEM_R(1e-5);
        CHECK_NEAR(dem_sizes_finer_get(world, &d, d.scale), 1 - exp(-1.0), 1e-5);
        memset(&d, 0, sizeof d);
        d.kind = DEM_SIZES_NORMAL;
        d.median = DEM_R(0.002);
        d.deviation = DEM_R(0.0003);
        CHECK_NEAR(dem_sizes_finer_get(world, &d, d.median), 0.5, 1e-6);
        CHECK_NEAR(dem_sizes_finer_get(world, &d, DEM_R(0.0023)), 0.8413447460685429, 1e-6);
        d.kind = DEM_SIZES_EXPONENTIAL;         /* min 1 mm, mean 3 mm */
        d.by_count = 1;
        d.min = DEM_R(0.001);
        d.scale = DEM_R(0.003);
        CHECK_NEAR(dem_sizes_finer_get(world, &d, DEM_R(0.003)), 1 - exp(-1.0), 1e-6);
        CHECK_EQ(dem_sizes_draw(world, &d, many, 0, radii), DEM_OK);
        {
            double sum = 0;
            for (i = 0; i < many; i++) sum += (double)radii[i]/many;
            CHECK_REL(sum, 0.003, 1e-3);
        }
        d.scale = d.min;
        CHECK_NEAR(dem_sizes_finer_get(world, &d, d.median), -1, 0);
        CHECK_STR(dem_world_error_get(world), "exponential");
        d = sieves();
        CHECK_NEAR(dem_sizes_finer_get(world, &d, DEM_R(0.49e-3)), 0, 0);
        CHECK_NEAR(dem_sizes_finer_get(world, &d, DEM_R(0.5e-3)), 0.1, 1e-9);
        CHECK_NEAR(dem_sizes_finer_get(world, &d, DEM_R(1.5e-3)), 0.55, 1e-6);
        CHECK_NEAR(dem_sizes_finer_get(world, &d, DEM_R(4e-3)), 1, 0);
        CHECK_EQ(dem_sizes_draw(world, &d, many, 0, radii), DEM_OK);
        CHECK_REL(radii[0], 0.5e-3, 1e-6);
        dem_world_destroy(world);
    }

    TEST("classes for a feed hold the fractions and number of the distribution; their feed inserts its mass") {
        dem_world *world = empty(0);
        dem_sizes d = sieves();
        dem_material m = scene_material(world, 1e7, 0.5, 0, 0);
        dem_feed_desc f;
        double sum = 0, number = 0, drawn = 0;
        int i;
        memset(&f, 0, sizeof f);
        f.class_count = dem_sizes_classes_get(world, &d, 8, f.radius, f.amount);
        CHECK_EQ(f.class_count, 8);
        for (i = 0; i < f.class_count; i++) {
            sum += f.amount[i];
            number += f.amount[i]/pow((double)f.radius[i], 3);
            if (i) CHECK(f.radius[i] > f.radius[i - 1]);
        }
        CHECK_NEAR(sum, 1, 1e-9);
        CHECK_EQ(dem_sizes_draw(world, &d, many, 0, radii), DEM_OK);
        for (i = 0; i < many; i++) drawn += pow((double)radii[i], 3);
        CHECK_REL(number, many/drawn, 5e-3);         /* grains per unit of mass */
        f.material = m;
        f.by_mass = 1;
        f.rate = 0.05;
        f.box = box_of(-0.05, -0.05, 0, 0.05, 0.05, 0.1);
        CHECK(dem_feed_add(world, &f).id == 1);
        dem_world_destroy(world);
    }

    TEST("a fill by sizes inserts all sizes without overlap, equally for equal seeds; a size without room is named") {
        dem_world *world = empty(0);
        dem_sizes d = sieves();
        dem_material m = scene_material(world, 1e7, 0.5, 0, 0);
        dem_region region;
        dem_bodies b;
        dem_contact_info none;
        int i;
        memset(&region, 0, sizeof region);
        region.box = box_of(0, 0, 0, 0.03, 0.03, 0.04);
        region.cylinder = 'z';
        CHECK_EQ(dem_sizes_fill(world, m, &d, region, 2000, 3), 2000);
        b = dem_bodies_get(world);
        for (i = 0; i < b.count; i++) {
            const double x = (double)b.positions[4*i] - 0.015, y = (double)b.positions[4*i + 1] - 0.015;
            const double r = (double)b.positions[4*i + 3];
            radii[i] = b.positions[4*i + 3];
            if (sqrt(x*x + y*y) > 0.015 - r + 1e-6) CHECK(0);
        }
        CHECK_NEAR(finer(radii, 2000, 3, 1.5e-3), 0.55, 0.03);
        CHECK_EQ(dem_candidates_rebuild(world), DEM_OK);
        CHECK_EQ(dem_contacts_get(world, &none, 0), 0);
        region.box = box_of(0, 0, 0.05, 0.01, 0.01, 0.06);
        CHECK(dem_sizes_fill(world, m, &d, region, 5000, 3) < 5000);
        CHECK_STR(dem_world_error_get(world), "dem_sizes_fill: ");
        CHECK_STR(dem_world_error_get(world), "found a free position");
        dem_world_destroy(world);
    }

    TEST("a fill of no spheres succeeds, and discs fill a cylinder along an axis of their plane; a box without end is rejected") {
        dem_world *world = empty(1);
        dem_sizes d = sieves();
        dem_material m = scene_material(world, 1e7, 0.5, 0, 0);
        dem_region region = dem_region_make(box_of(0, 0, 0, 0.03, 0.03, 0));
        const double endless[] = {(double)INFINITY, -(double)INFINITY, (double)NAN, 1e16};
        int k;
        CHECK_EQ(dem_sizes_fill(world, m, &d, region, 0, 1), 0);
        CHECK_EQ(dem_spheres_fill(world, m, DEM_R(1e-3), region, 0, 1), 0);
        CHECK_STR(dem_world_error_get(world), "");
        CHECK_EQ(dem_world_step(world, 1), DEM_OK);
        for (k = 0; k < 3; k++) {
            region.cylinder = "xyz"[k];
            CHECK_EQ(dem_spheres_fill(world, m, DEM_R(1e-3), region, 10, 1), 10);
        }
        for (k = 0; k < 4; k++) {
            region.box.hi.x = (dem_real)endless[k];
            CHECK_EQ(dem_spheres_fill(world, m, DEM_R(1e-3), region, 1, 1), 0);
            CHECK_STR(dem_world_error_get(world), "must be finite and at most 1e+15 m from the origin");
        }
        dem_world_destroy(world);
    }

    TEST("invalid size distributions are rejected with the value named") {
        dem_world *world = empty(0);
        dem_sizes d = DEM_SIZES;
        CHECK_EQ(dem_sizes_draw(world, &d, 10, 0, radii), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "0 < min <= max");
        d.min = d.max = DEM_R(0.001);
        CHECK_EQ(dem_sizes_draw(world, &d, 10, 0, radii), DEM_OK);
        CHECK_REL(radii[9], 0.001, 1e-6);
        CHECK_EQ(dem_sizes_draw(world, &d, -1, 0, radii), DEM_ERROR_ARGUMENT);
        CHECK_EQ(dem_sizes_draw(world, &d, 1, 0, 0), DEM_ERROR_ARGUMENT);
        d.kind = DEM_SIZES_LOGNORMAL;
        CHECK_EQ(dem_sizes_draw(world, &d, 10, 0, radii), DEM_ERROR_ARGUMENT);
        d = sieves();
        d.passing[3] = 100;
        CHECK_EQ(dem_sizes_draw(world, &d, 10, 0, radii), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "not 100 per cent");
        d = sieves();
        d.radius[2] = d.radius[1];
        CHECK_NEAR(dem_sizes_finer_get(world, &d, DEM_R(1)), -1, 0);
        d = sieves();
        CHECK_EQ(dem_sizes_classes_get(world, &d, 17, radii, 0), 0);
        dem_world_destroy(world);
    }
    TEST("a distribution of any kind and limits is rejected or draws radii between its limits") {
        static const double ends[] = {0, 1e-300, 1e-100, 1e-38, 1e-16, 1e-9, 1e-3, 1, 1e14, 1e30, 1e300};
        dem_world *world = empty(0);
        int kind, i, j, k, drawn = 0;
        for (kind = 0; kind < 6; kind++)
            for (i = 0; i < 11; i++)
                for (j = i; j < 11; j++)
                    for (k = 0; k < 2; k++) {
                        dem_sizes d = DEM_SIZES;
                        double amount[DEM_CLASSES];
                        int n, bad = 0;
                        d.kind = (dem_sizes_kind)kind;
                        d.by_count = k;
                        d.min = (dem_real)ends[i];
                        d.max = (dem_real)ends[j];
                        d.median = DEM_R(8e-4); d.spread = 0.3; d.scale = DEM_R(9e-4); d.modulus = 3;
                        d.deviation = DEM_R(1e-4);
                        d.count = 2; d.radius[0] = DEM_R(5e-4); d.radius[1] = DEM_R(1e-3);
                        d.passing[0] = 0.1; d.passing[1] = 1;
                        if (dem_sizes_draw(world, &d, 40, 1, radii) != DEM_OK) {
                            CHECK_STR(dem_world_error_get(world), "dem_sizes_draw: sizes, ");
                            continue;
                        }
                        drawn++;
                        for (n = 0; n < 40; n++)
                            bad += !(radii[n] >= DEM_R(0.99e-15) && radii[n] < DEM_R(1e15)) ||
                                (d.max > 0 && radii[n] > d.max*DEM_R(1.00001));
                        CHECK_EQ(bad, 0);
                        n = dem_sizes_classes_get(world, &d, DEM_CLASSES, radii, amount);
                        CHECK(n > 0);
                        while (n-- > 0) CHECK(radii[n] > 0 && radii[n] < DEM_R(1e15) && amount[n] > 0 && amount[n] <= 1);
                    }
        CHECK(drawn > 100);
        dem_world_destroy(world);
    }
    TEST("a sieve curve in per cent is rejected with a hint, in whichever call") {
        dem_world *world = empty(0);
        dem_material m = scene_material(world, 1e7, 0.5, 0.5, 0);
        dem_sizes d = sieves();
        dem_region region = DEM_REGION;
        dem_feed_desc feed = DEM_FEED_DESC;
        int k;
        for (k = 0; k < d.count; k++) d.passing[k] *= 100;
        region.box = feed.box = box_of(0, 0, 0, 1, 1, 1);
        CHECK_EQ(dem_sizes_fill(world, m, &d, region, 10, 1), 0);
        CHECK_STR(dem_world_error_get(world), "dem_sizes_fill: sizes, sieves: the last entry of passing is 100, must be 1");
        feed.material = m;
        feed.class_count = 1;
        feed.amount[0] = feed.rate = 1;
        feed.sizes[0] = &d;
        CHECK_EQ(dem_feed_add(world, &feed).id, 0);
        CHECK_STR(dem_world_error_get(world), "dem_feed_add: sizes, sieves: the last entry of passing is 100, must be 1");
        dem_world_destroy(world);
    }
    return test_end();
}
