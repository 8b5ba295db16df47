/* Grains from files: what dem.h writes, extended XYZ of others, text and CSV; and what is wrong with them. */
#define DEM_IMPLEMENTATION
#include "../dem.h"
#include "test.h"
#include "scene.h"

static const int fine = sizeof(dem_real) == 8;       /* double precision */

static dem_world *heap(void) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material a, b;
    desc.gravity = at(0, 0, -9.81);
    desc.dt = DEM_R(1e-5);
    world = dem_world_create(&desc);
    a = scene_material(world, 1e6, 0.5, 0.3, 0.1);
    b = scene_material(world, 1e6, 0.5, 0.3, 0.1);
    dem_plane_add(world, a, at(0, 0, 0), at(0, 0, 1));
    (void)b;
    return world;
}
static dem_result parse(dem_world *world, const char *text, dem_grains *g) {
    return dem_grains_parse(world, "some.csv", text, strlen(text), g);
}
static void refused(dem_world *world, const char *text, const char *why) {
    dem_grains g;
    CHECK_EQ(parse(world, text, &g), DEM_ERROR_FORMAT);
    CHECK_STR(dem_world_error(world), "dem_grains_parse: some.csv");
    CHECK_STR(dem_world_error(world), why);
    CHECK(!g.positions && !g.count);
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("a snapshot that was written as VTP is read back to the last bit, as XYZ to nine digits, materials included, and a "
         "world of those grains goes on like the first") {
        dem_world *world = heap(), *again = heap(), *text = heap();
        dem_material a, b, own;
        dem_grains g, x;
        dem_bodies bodies;
        int i, k;
        a.id = 1;
        b.id = 2;
        own.id = 0;
        CHECK_EQ(dem_spheres_fill(world, a, DEM_R(0.005), box_of(-0.03, -0.03, 0.01, 0.03, 0.03, 0.06), 40, 1), 40);
        CHECK_EQ(dem_spheres_fill(world, b, DEM_R(0.003), box_of(-0.03, -0.03, 0.01, 0.03, 0.03, 0.06), 40, 1), 40);
        dem_temperature_set(world, 0.05, 3);
        for (i = 0; i < 80; i++) {
            dem_body_state s = scene_state(world, dem_bodies_id(world, i));
            s.spin = at(i, 2, 3);
            dem_body_set(world, dem_bodies_id(world, i), &s);
        }
        CHECK_EQ(dem_vtp_write(world, "build/tmp/grains.vtp"), DEM_OK);
        CHECK_EQ(dem_xyz_write(world, "build/tmp/grains.xyz"), DEM_OK);
        CHECK_EQ(dem_grains_read(again, "build/tmp/grains.vtp", &g), DEM_OK);
        CHECK_EQ(dem_grains_read(text, "build/tmp/grains.xyz", &x), DEM_OK);
        bodies = dem_bodies_get(world);
        CHECK_EQ(g.count, 80);
        CHECK_EQ(x.count, 80);
        for (i = 0; i < 80; i++) {
            CHECK(g.materials && g.materials[i] == bodies.materials[i]);
            CHECK(g.radii[i] >= bodies.positions[4*i + 3] && g.radii[i] <= bodies.positions[4*i + 3]);
            for (k = 0; k < 3; k++) {
                CHECK_NEAR(g.positions[3*i + k], bodies.positions[4*i + k], 0);
                CHECK_NEAR(g.velocities[3*i + k], bodies.velocities[4*i + k], 0);
                CHECK_NEAR(g.spins[3*i + k], bodies.spins[4*i + k], 0);
                CHECK_NEAR(x.positions[3*i + k], bodies.positions[4*i + k], fine ? 1e-9 : 1e-7);
                CHECK_NEAR(x.velocities[3*i + k], bodies.velocities[4*i + k], fine ? 1e-8 : 1e-6);
            }
        }
        CHECK_EQ(dem_grains_add(again, own, &g), DEM_OK);
        CHECK_EQ(dem_grains_add(text, own, &x), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error(text), "material is null and the grains have none");
        CHECK_EQ(dem_grains_add(text, a, &x), DEM_OK);
        CHECK_EQ(dem_world_run_to(world, 0.02, 0, 0), DEM_OK);
        CHECK_EQ(dem_world_run_to(again, 0.02, 0, 0), DEM_OK);
        CHECK_NEAR(dem_totals_get(again).kinetic, dem_totals_get(world).kinetic, (fine ? 1e-9 : 1e-3)*dem_totals_get(world).kinetic);
        CHECK_REL(dem_totals_get(text).mass, dem_totals_get(world).mass, 1e-6);
        g.materials[79] = 3;
        CHECK_EQ(dem_grains_add(again, own, &g), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error(again), "material 3 does not exist");
        CHECK_EQ((int)dem_balance_get(again).present, 80);      /* all or nothing */
        dem_grains_free(again, &g);
        dem_grains_free(text, &x);
        dem_world_destroy(world);
        dem_world_destroy(again);
        dem_world_destroy(text);
    }

    TEST("text and CSV: with names in any order, diameters, semicolons and comments, or by position; other codes' XYZ by its "
         "Properties") {
        dem_world *world = heap();
        dem_grains g;
        CHECK_EQ(parse(world, "# made by hand\nname, d, z, y, x, vz\na, 0.02, 3, 2, 1, -5\nb;0.04;6;5;4;7 # last\n", &g), DEM_OK);
        CHECK_EQ(g.count, 2);
        CHECK_NEAR(g.radii[1], 0.02, 1e-9);
        CHECK_NEAR(g.positions[0], 1, 0);
        CHECK_NEAR(g.positions[5], 6, 0);
        CHECK_NEAR(g.velocities[2], -5, 0);
        CHECK_NEAR(g.velocities[0], 0, 0);
        CHECK(!g.spins && !g.materials);
        dem_grains_free(world, &g);
        CHECK_EQ(parse(world, "1 2 3 .5\n4 5 6 .25", &g), DEM_OK);
        CHECK_EQ(g.count, 2);
        CHECK_NEAR(g.positions[3], 4, 0);
        CHECK_NEAR(g.radii[0], 0.5, 0);
        CHECK(!g.velocities);
        dem_grains_free(world, &g);
        CHECK_EQ(parse(world, "1,2,3,.5,7,8,9\r\n", &g), DEM_OK);
        CHECK_EQ(g.count, 1);
        CHECK_NEAR(g.velocities[2], 9, 0);
        dem_grains_free(world, &g);
        CHECK_EQ(parse(world, "x,y,r,material\n1,2,.5,2\n", &g), DEM_OK);     /* discs */
        CHECK_NEAR(g.positions[2], 0, 0);
        CHECK_EQ(g.materials[0], 2);
        dem_grains_free(world, &g);
        CHECK_EQ(parse(world, "2\nLattice=\"1 0 0 0 1 0 0 0 1\" Properties=radius:R:1:id:I:1:pos:R:3:species:S:1 Time=3\n"
                       ".5 7 1 2 3 Si\n.25 8 4 5 6 O\n2\nanother frame\n", &g), DEM_OK);
        CHECK_EQ(g.count, 2);
        CHECK_NEAR(g.radii[1], 0.25, 0);
        CHECK_NEAR(g.positions[5], 6, 0);
        dem_grains_free(world, &g);
        CHECK_EQ(parse(world, "0\nProperties=pos:R:3:radius:R:1\n", &g), DEM_OK);
        CHECK_EQ(g.count, 0);
        { dem_material none; none.id = 0; CHECK_EQ(dem_grains_add(world, none, &g), DEM_OK); }
        dem_grains_free(world, &g);
        dem_grains_free(world, &g);                  /* twice does no harm */
        dem_world_destroy(world);
    }

    TEST("what is wrong with a file of grains is told with its line, and nothing is left behind") {
        dem_world *world = heap();
        dem_grains g;
        refused(world, "", "line 0: found the end of the file where grains are expected");
        refused(world, "1 2 3\n", "4 columns are expected (x y z r), or 7");
        refused(world, "1 2 3 .5\n1 2 3\n", "line 2: found the end of the line where a number is expected for each column");
        refused(world, "1 2 3 .5\n1 2 3 .5 6\n", "line 2: found '6' where the line should end");
        refused(world, "1 2 3 .5\n1 2 nan .5\n", "line 2: found 'nan'");
        refused(world, "1 2 3 .5\n1 2 3 -1\n", "line 2: found '-1' where a radius");
        refused(world, "x y z\n1 2 3\n", "columns x, y and r (radius) or d (diameter) are needed");
        refused(world, "5\nno properties here\nH 1 2 3\n", "Properties=");
        refused(world, "5\nProperties=species:S:1:pos:R:3:radius:R:1\nH 1 2 3 .5\n", "1 lines of grains where it says 5");
        refused(world, "tea and cakes\n", "numbers are expected, or names of columns");
        refused(world, "x y r material\n1 2 .5 1.5\n", "a material is expected, a whole number");
        refused(world, "<?xml version=\"1.0\"?><VTKFile>", "has no appended raw data");
        CHECK_EQ(dem_grains_parse(world, 0, "a\0b", 3, &g), DEM_ERROR_FORMAT);
        CHECK_STR(dem_world_error(world), "not text");
        CHECK_EQ(dem_grains_read(world, "build/tmp/there_is_none.csv", &g), DEM_ERROR_FILE);
        CHECK_EQ(dem_grains_read(world, 0, &g), DEM_ERROR_ARGUMENT);
        {                                            /* a VTP file cut anywhere is refused */
            dem_material a;
            FILE *f;
            static char bytes[8000];
            size_t size, cut;
            int whole = 0;
            a.id = 1;
            dem_sphere_add(world, a, DEM_R(0.01), at(0, 0, 1));
            dem_sphere_add(world, a, DEM_R(0.02), at(0, 1, 1));
            CHECK_EQ(dem_vtp_write(world, "build/tmp/cut.vtp"), DEM_OK);
            f = fopen("build/tmp/cut.vtp", "rb");
            CHECK(f != 0);
            size = f ? fread(bytes, 1, sizeof bytes, f) : 0;
            if (f) fclose(f);
            for (cut = 0; cut < size; cut++) {
                if (dem_grains_parse(world, "cut", bytes, cut, &g) == DEM_OK) { whole++; CHECK_EQ(g.count, 2); }
                dem_grains_free(world, &g);
            }
            CHECK(whole < 100);                      /* only what comes after the last array may be missing */
            CHECK_EQ(dem_grains_parse(world, "whole", bytes, size, &g), DEM_OK);
            dem_grains_free(world, &g);
        }
        dem_world_destroy(world);
    }
    return test_end();
}
