/* Curves over time of a machine with decks (examples/sifting.h): what lies on each deck, what has reached it, when a curve is
   steady, means and spreads of several runs. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../../examples/sorting.h"
#include "../../examples/study.h"
#include "../../examples/sifting.h"
#include "../test.h"
#include "../scene.h"

enum { DECKS = 3 };
/* Three decks 0.1 m apart, tilted with their frame, each with an outlet that takes nothing. */
static dem_world *machine(dem_wall *frame, dem_outlet *outlets, dem_feed *feed, dem_material *stuff) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc m = DEM_MATERIAL_DESC;
    dem_feed_desc f = DEM_FEED_DESC;
    dem_world *world;
    int k;
    desc.dt = DEM_R(1e-5);
    world = dem_world_create(&desc);
    m.density = 1000;
    m.young = DEM_R(1e6);
    m.poisson = DEM_R(0.3);
    m.restitution = DEM_R(0.5);
    *stuff = dem_material_add(world, &m);
    *frame = dem_wall_plane_add(world, *stuff, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
    for (k = 0; k < DECKS; k++) {
        dem_outlet_desc o = DEM_OUTLET_DESC;
        o.box = dem_box_make(50, 50, 50, 51, 51, 51);
        o.wanted_min = DEM_R(0.009);
        outlets[k] = dem_outlet_add(world, &o);
    }
    f.material = *stuff;
    f.class_count = 1;
    f.radius[0] = DEM_R(0.01);
    f.amount[0] = 1;
    f.rate = 1;
    f.start = 100;
    f.box = dem_box_make(10, 10, 10, 11, 11, 11);
    *feed = dem_feed_add(world, &f);
    return world;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("a grain counts on the deck below it, as undersize if it is smaller than those wanted there") {
        static const double wanted[DECKS] = {0.005, 0.009, 0.009};
        static const double radius[4] = {0.005, 0.005, 0.01, 0.01}, z[4] = {0.05, 0.15, 0.15, 0.35};
        static sifting s;
        dem_outlet outlets[DECKS];
        dem_wall frame;
        dem_feed feed;
        dem_material stuff;
        dem_world *world = machine(&frame, outlets, &feed, &stuff);
        double mass[4];
        int i;
        for (i = 0; i < 4; i++) {
            dem_sphere_add(world, stuff, (dem_real)radius[i], dem_vec3_make((dem_real)(0.1*i), 0, (dem_real)z[i]));
            mass[i] = 1000*4*3.14159265358979323846/3*radius[i]*radius[i]*radius[i];
        }
        CHECK(outlets[DECKS - 1].id && frame.id && feed.id);
        sifting_begin(&s, world, frame, 0.1, outlets, wanted, DECKS, feed, 1);
        sifting_take(&s);
        CHECK(s.samples == 1);
        CHECK_REL(s.value[SIFTING_ON][0][0], mass[0], 1e-6);
        CHECK_REL(s.value[SIFTING_ON][1][0], mass[1] + mass[2], 1e-6);
        CHECK_REL(s.value[SIFTING_UNDER][1][0], mass[1], 1e-6);
        CHECK_REL(s.value[SIFTING_OVER][1][0], mass[2], 1e-6);
        CHECK_REL(s.value[SIFTING_ON][2][0], mass[3], 1e-6);           /* above the highest deck */
        CHECK_REL(s.value[SIFTING_THROUGH][2][0], mass[0] + mass[1] + mass[2] + mass[3], 1e-6);
        CHECK_REL(s.value[SIFTING_THROUGH][0][0], mass[0], 1e-6);
        dem_world_destroy(world);
    }

    TEST("a mass that grows in proportion to time is a constant flow") {
        static sifting s;
        int i;
        memset(&s, 0, sizeof s);
        s.decks = 1;
        s.samples = SIFTING_SAMPLES;
        for (i = 0; i < s.samples; i++) { s.time[i] = 0.5*i; s.value[SIFTING_OUT][0][i] = 3*s.time[i]; }
        sifting_end(&s);
        for (i = 0; i < s.samples; i++) CHECK_NEAR(s.value[SIFTING_OUT][0][i], 3, 1e-12);
    }

    TEST("an exponential approach is steady when it has come within the tolerance of its end") {
        static sifting s;
        int i;
        memset(&s, 0, sizeof s);
        s.decks = 1;
        s.samples = SIFTING_SAMPLES;
        for (i = 0; i < s.samples; i++) { s.time[i] = 0.1*i; s.value[SIFTING_EFFICIENCY][1][i] = 70*(1 - exp(-s.time[i])); }
        CHECK_NEAR(sifting_steady(&s, SIFTING_EFFICIENCY, 1, 2), log(35), 0.1);
    }

    TEST("the mean and spread of two runs are those of two numbers") {
        static sifting sum, s;
        memset(&sum, 0, sizeof sum);
        memset(&s, 0, sizeof s);
        s.decks = 1;
        s.samples = 1;
        s.value[SIFTING_SORTED][0][0] = 10;
        sifting_add(&sum, &s);
        s.value[SIFTING_SORTED][0][0] = 14;
        sifting_add(&sum, &s);
        CHECK_NEAR(sum.value[SIFTING_SORTED][0][0], 12, 1e-12);
        CHECK_NEAR(sifting_spread(&sum, SIFTING_SORTED, 0, 0), sqrt(8.0), 1e-12);
    }

    return test_end();
}
