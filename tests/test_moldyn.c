/* MOLDYN's files: the appendix's own lines, a scene of three files run and written, what is refused. */
#define DEM_IMPLEMENTATION
#include "../dem.h"
#include "test.h"
#include "scene.h"

static const char cin[] =
    "times.t0          0.00\ntimes.tend        10.0\ntimes.dt          1.0e-5\n"
    "control.grav      -9.81\ncontrol.rho       20.0\ncontrol.mue_s     0.45\n"
    "control.mue_d     0.45\nsd.stiff_lo       7.25e3\nsd.stiff_k_un     7.25e3\n"
    "sd.stiff_adh      -3.00e2\nsd.damp_particle  0.00\nsd.damp_wall      0.38\nsd.e              0.27\n";
static const char pin[] =
    "6\n-1.7  0.0  2.2  0.0  1.0  0.5  0.0  0.0  0.0  0.0  0.0  0.0  0.13  1\n"
    " 1.5  0.3  1.4  0.0  0.0  0.0  0.0  0.0  0.0  0.0  0.0  0.0  0.15  0\n"
    "-2.6  0.4  2.1  0.0  1.0  0.1  0.0  0.0  0.0  0.0  0.0  0.0  0.15  1\n"
    " 3.5  0.2  2.0  0.0  0.0  0.0  0.0  0.0  0.0  0.0  0.0  0.0  0.17  0\n"
    " 3.5  0.2  4.1  2.4  1.0  1.2  0.0  0.0  0.0  0.0  0.0  0.0  0.13  1\n"
    " 4.2  0.3  2.8  0.6  0.0  0.8  0.0  0.0  0.0  0.0  0.0  0.0  0.15  1\n";
static const char win[] =
    "6  0.0030\n 1.0000  0.0000  0.0000 -0.0050  0.0855  0.0855\n"
    "-1.0000  0.0000  0.0000  0.1715  0.0855  0.0855\n"
    " 0.0000  1.0000  0.0000  0.0855 -0.0005  0.0855\n"
    " 0.0000 -1.0000  0.0000  0.0855  0.1715  0.0855\n"
    " 0.0000  0.0000  1.0000  0.0855  0.0855 -0.0005\n"
    " 0.0000  0.0000 -1.0000  0.0855  0.0855  0.1715\n";

static dem_world *any_world(void) {
    dem_world_desc desc = DEM_WORLD_DESC;
    return dem_world_create(&desc);
}
static dem_result parse(dem_world *w, dem_moldyn *m, dem_moldyn_file file, const char *text) {
    return dem_moldyn_parse(w, "text", file, text, strlen(text), m);
}
static void save(const char *path, const char *text) {
    FILE *file = fopen(path, "wb");
    if (!file) return;
    fputs(text, file);
    fclose(file);
}
static void load(const char *path, char *text, size_t room) {
    FILE *file = fopen(path, "rb");
    const size_t n = file ? fread(text, 1, room - 1, file) : 0;
    text[n] = 0;
    if (file) fclose(file);
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("the three input files of the thesis's appendix are read as printed") {
        dem_world *w = any_world();
        dem_moldyn m = DEM_MOLDYN;
        CHECK_EQ(parse(w, &m, DEM_MOLDYN_CONTROL, cin), DEM_OK);
        CHECK_EQ(parse(w, &m, DEM_MOLDYN_PARTICLES, pin), DEM_OK);
        CHECK_EQ(parse(w, &m, DEM_MOLDYN_WALLS, win), DEM_OK);
        CHECK_NEAR(m.end, 10, 0);
        CHECK_REL(m.dt, 1e-5, 1e-6);
        CHECK_REL(m.gravity, -9.81, 1e-6);
        CHECK_REL(m.stiffness, 7250, 1e-6);
        CHECK_REL(m.stiffness_adhesion, 300, 1e-6);
        CHECK_REL(m.damping_wall, 0.38, 1e-6);
        CHECK_REL(m.restitution, 0.27, 1e-6);
        CHECK_EQ(m.grain_count, 6);
        CHECK_EQ(m.planar, 0);
        CHECK_REL((double)m.grains[14*4 + 3], 2.4, 1e-6);
        CHECK_REL((double)m.grains[14*3 + 12], 0.17, 1e-6);
        CHECK_EQ((int)m.grains[14*3 + 13], 0);
        CHECK_EQ(m.wall_count, 6);
        CHECK_REL(m.wall_thickness, 0.003, 1e-6);
        CHECK_REL((double)m.walls[6*5 + 5], 0.1715, 1e-6);
        dem_moldyn_free(&m);
        CHECK_EQ(m.grain_count, 0);
        dem_world_destroy(w);
    }

    TEST("a scene given by three files runs, is written, read back, and goes on the same") {
        static const char small[] =
            "times.tend 0.4\ntimes.dt 2e-5\ncontrol.grav -9.81\ncontrol.rho 2500\ncontrol.mue_s .3\n"
            "control.mue_d .2\nsd.stiff_lo 2000\nsd.stiff_k_un 3000\nsd.stiff_adh -100\n"
            "sd.damp_wall 0.5\nsd.damp_particle 0.1\n";
        static const char grains[] =
            "4\n.05 .05 .02 0 0 0 0 0 0 0 0 0 .01 1\n.05 .052 .045 0 .1 0 0 0 0 0 0 0 .012 1\n"
            ".1 .1 .01 0 0 0 0 0 0 0 0 0 .012 0\n.1 .105 .06 0 0 0 0 0 0 0 5 0 .01 1\n";
        static const char *path[] = {"build/tmp/m.cin", "build/tmp/m.pin", "build/tmp/m.win",
                                     "build/tmp/n.cin", "build/tmp/n.pin", "build/tmp/n.win"};
        dem_world *any = any_world(), *a, *b;
        dem_world_desc desc;
        dem_moldyn m, n;
        dem_bodies ba, bb;
        int i, k;
        save(path[0], small); save(path[1], grains); save(path[2], win);
        CHECK_EQ(dem_moldyn_read(any, path[0], path[1], path[2], &m), DEM_OK);
        desc = dem_moldyn_desc(&m);
        CHECK_EQ((int)desc.normal_law, (int)DEM_NORMAL_HYSTERETIC);
        a = dem_world_create(&desc);
        CHECK_EQ(dem_moldyn_add(a, &m), DEM_OK);
        CHECK_EQ(dem_world_run(a, m.end - m.start, 0, 0), DEM_OK);
        for (k = 0; k < 4; k++) {                /* they lie on the walls' surfaces, 1.5 mm inside */
            const dem_body_state s = scene_state(a, dem_bodies_id(a, k));
            CHECK(s.fixed || (double)(s.position.z - s.radius) > 0.001 - 0.0005);
        }
        CHECK_EQ(dem_moldyn_take(a, &m), DEM_OK);
        CHECK_EQ(dem_moldyn_write(a, &m, path[3], path[4], path[5]), DEM_OK);
        CHECK_EQ(dem_moldyn_read(any, path[3], path[4], path[5], &n), DEM_OK);
        CHECK_EQ(n.grain_count, 4);
        CHECK(memcmp(n.grains, m.grains, 14*4*sizeof(dem_real)) == 0);
        CHECK(memcmp(n.walls, m.walls, 6*6*sizeof(dem_real)) == 0);
        CHECK(n.start >= m.start && n.start <= m.start);
        CHECK_REL(n.stiffness_adhesion, m.stiffness_adhesion, 1e-6);
        b = dem_world_create(&desc);
        CHECK_EQ(dem_moldyn_add(b, &n), DEM_OK);
        ba = dem_bodies_get(a);
        bb = dem_bodies_get(b);
        CHECK_EQ(ba.count, bb.count);
        for (i = 0; i < 4; i++)                  /* b's are in the order of a's slots */
            for (k = 0; k < 4; k++)
                if (ba.slots[i] == bb.slots[k]) {
                    CHECK(memcmp(ba.positions + 4*i, bb.positions + 4*k, 4*sizeof(dem_real)) == 0);
                    CHECK(memcmp(ba.velocities + 4*i, bb.velocities + 4*k, 3*sizeof(dem_real)) == 0);
                }
        CHECK_EQ(dem_world_run(b, 0.05, 0, 0), DEM_OK);
        dem_moldyn_free(&m);
        dem_moldyn_free(&n);
        dem_world_destroy(a);
        dem_world_destroy(b);
        dem_world_destroy(any);
        for (i = 0; i < 6; i++) remove(path[i]);
    }

    TEST("damping and restitution of .cin come out in the bounce: sd.e between grains, damp_wall at "
         "walls") {
        dem_world *any = any_world(), *w;
        dem_moldyn m = DEM_MOLDYN;
        dem_world_desc desc;
        dem_material grain, wall;
        dem_coefficients c;
        parse(any, &m, DEM_MOLDYN_CONTROL, cin);
        parse(any, &m, DEM_MOLDYN_WALLS, win);
        desc = dem_moldyn_desc(&m);
        CHECK_EQ((int)desc.normal_law, (int)DEM_NORMAL_LINEAR);        /* unloads as it loads */
        w = dem_world_create(&desc);
        CHECK_EQ(dem_moldyn_add(w, &m), DEM_OK);
        grain.id = 1; wall.id = 2;
        CHECK_EQ(dem_coefficients_get(w, grain, grain, DEM_R(0.15), DEM_R(0.15), &c), DEM_OK);
        CHECK_REL(exp(-3.14159265*(double)c.damping_ratio/sqrt(1 - (double)c.damping_ratio*
                  (double)c.damping_ratio)), 0.27, 1e-5);
        CHECK_EQ(dem_coefficients_get(w, grain, wall, DEM_R(0.15), 0, &c), DEM_OK);
        CHECK_REL(c.cn, 0.38, 1e-6);
        dem_moldyn_free(&m);
        dem_world_destroy(w);
        dem_world_destroy(any);
    }

    TEST("files in a plane have 8 and 4 columns, gravity along y, and make a planar world") {
        dem_world *any = any_world(), *w;
        dem_moldyn m = DEM_MOLDYN;
        dem_world_desc desc;
        dem_body_state s;
        parse(any, &m, DEM_MOLDYN_CONTROL, cin);
        CHECK_EQ(parse(any, &m, DEM_MOLDYN_PARTICLES, "2\n0 1 .5 0 0 2 .1 1\n3 0 0 0 0 0 .1 0\n"),
                 DEM_OK);
        CHECK_EQ(parse(any, &m, DEM_MOLDYN_WALLS, "1 .02\n0 1 0 0\n"), DEM_OK);
        CHECK_EQ(m.planar, 1);
        m.damping_wall = 100;                    /* a disc of .6 kg: at rest soon */
        desc = dem_moldyn_desc(&m);
        w = dem_world_create(&desc);
        CHECK_EQ(dem_moldyn_add(w, &m), DEM_OK);
        s = scene_state(w, dem_bodies_id(w, 0));
        CHECK_NEAR(s.position.y, 1, 1e-6);
        CHECK_NEAR(s.spin.z, 2, 1e-6);
        CHECK_NEAR(s.velocity.x, 0.5, 1e-6);
        CHECK_EQ(dem_world_run(w, 2, 0, 0), DEM_OK);
        s = scene_state(w, dem_bodies_id(w, scene_state(w, dem_bodies_id(w, 0)).fixed));
        CHECK_NEAR(s.position.y, 0.11, 0.003);   /* on the wall's surface, .01 above its middle */
        dem_moldyn_free(&m);
        dem_world_destroy(w);
        dem_world_destroy(any);
    }

    TEST(".xb and .str files look as the appendix shows them") {
        static const char xb[] = "build/tmp/a.xb", str[] = "build/tmp/a.str";
        dem_world *any = any_world(), *w;
        dem_moldyn m = DEM_MOLDYN;
        dem_world_desc desc;
        char text[2000];
        remove(xb);
        remove(str);
        parse(any, &m, DEM_MOLDYN_CONTROL, cin);
        parse(any, &m, DEM_MOLDYN_PARTICLES, "1\n.05 .12 0 0 0 0 .004 1\n");
        parse(any, &m, DEM_MOLDYN_WALLS, "1 .003\n0 1 0 -5\n");
        desc = dem_moldyn_desc(&m);
        w = dem_world_create(&desc);
        dem_moldyn_add(w, &m);
        CHECK_EQ(dem_xb_append(w, xb, dem_box_make(0, 0, 0, DEM_R(0.171), DEM_R(0.171), 0)), DEM_OK);
        CHECK_EQ(dem_str_append(w, str, 0.01, 2), DEM_OK);
        dem_world_step(w, 1);
        CHECK_EQ(dem_xb_append(w, xb, dem_box_make(0, 0, 0, DEM_R(0.171), DEM_R(0.171), 0)), DEM_OK);
        CHECK_EQ(dem_str_append(w, str, 0.01, 2), DEM_OK);
        load(xb, text, sizeof text);
        /* the second frame has the appendix's own -0.000098 m/s of one step of 1e-5 s */
        CHECK(strcmp(text, "1 0 0.000000 0.000000 0.171000 0.171000\n"
                     "0.050000 0.120000 0.000000 0.000000 0.004000 0.000000\n"
                     "1 1e-05 0.000000 0.000000 0.171000 0.171000\n"
                     "0.050000 0.120000 0.000000 -0.000098 0.004000 0.000000\n") == 0);
        load(str, text, sizeof text);
        CHECK_STR(text, "0.01 2 2\n1 0 0 0 1 0 0 0 1 0.050000 0.120000 0.000000\n");
        CHECK_EQ((int)(strstr(text, "0.120000") != strstr(text, "0.01")), 1);
        dem_moldyn_free(&m);
        dem_world_destroy(w);
        dem_world_destroy(any);
        remove(xb);
        remove(str);
    }

    TEST("malformed files are refused with line and reason, and what was read before stays") {
        static const struct { dem_moldyn_file file; const char *text, *says; } rows[] = {
            {DEM_MOLDYN_CONTROL, "", "a line with times.tend is expected"},
            {DEM_MOLDYN_CONTROL, "times.tend 1\ntimes.ende 2\n", "line 2: found 'times.ende'"},
            {DEM_MOLDYN_CONTROL, "times.tend 1\ntimes.tend 2\n", "each once"},
            {DEM_MOLDYN_CONTROL, "times.dt 0\n", "line 1: found '0' where the value of times.dt"},
            {DEM_MOLDYN_CONTROL, "sd.stiff_adh 3\n", "the value of sd.stiff_adh"},
            {DEM_MOLDYN_CONTROL, "times.dt nan\n", "found 'nan'"},
            {DEM_MOLDYN_CONTROL, "times.dt 1 2\n", "one value to a key"},
            {DEM_MOLDYN_CONTROL, "times.tend 1\ntimes.dt 1\ncontrol.rho 1\nsd.stiff_lo 1\n"
             "control.mue_d .4\ncontrol.mue_s .3\n", "control.mue_s of at least"},
            {DEM_MOLDYN_PARTICLES, "", "the number of grains"},
            {DEM_MOLDYN_PARTICLES, "-1\n", "the number of grains"},
            {DEM_MOLDYN_PARTICLES, "999999999\n1 2 3\n", "cut short"},
            {DEM_MOLDYN_PARTICLES, "1\n0 0 0 0 0 0 0 0 0 0 0 0 .1\n", "14 numbers"},
            {DEM_MOLDYN_PARTICLES, "1\n0 0 0 0 0 0 0 0 0 0 0 0 .1 1 7\n", "14 numbers"},
            {DEM_MOLDYN_PARTICLES, "1\n0 0 0 0 0 0 0 0 0 0 0 0 0 1\n", "a radius > 0"},
            {DEM_MOLDYN_PARTICLES, "1\n0 0 0 0 0 0 0 0 0 0 0 0 .1 2\n", "1 (moves)"},
            {DEM_MOLDYN_PARTICLES, "2\n0 0 0 0 0 0 .1 1\n0 0 0 0 0 0 0 0 0 0 0 0 .1 1\n",
             "line 3: found '0.1' where row 2 of 2"},
            {DEM_MOLDYN_PARTICLES, "1\n0 0 0 0 0 0 0 0 0 0 0 0 .1 1\n0\n", "more rows"},
            {DEM_MOLDYN_PARTICLES, "1\n0 0 x 0 0 0 0 0 0 0 0 0 .1 1\n", "line 2: found 'x'"},
            {DEM_MOLDYN_WALLS, "1\n", "the thickness"},
            {DEM_MOLDYN_WALLS, "1 -1\n1 0 0 0 0 0\n", "the thickness"},
            {DEM_MOLDYN_WALLS, "1 .1\n0 0 0 0 0 0\n", "a normal that is not 0"},
            {DEM_MOLDYN_WALLS, "1 .1\n1 0 0 0\n", "as the other file"}};
        dem_world *w = any_world();
        dem_moldyn m = DEM_MOLDYN;
        size_t i;
        parse(w, &m, DEM_MOLDYN_CONTROL, cin);
        parse(w, &m, DEM_MOLDYN_PARTICLES, pin);
        for (i = 0; i < sizeof rows/sizeof *rows; i++) {
            CHECK_EQ(parse(w, &m, rows[i].file, rows[i].text), DEM_ERROR_FORMAT);
            if (rows[i].says[0]) CHECK_STR(dem_world_error(w), i == 15 ? "row 2 of 2" : rows[i].says);
            CHECK_EQ(m.grain_count, 6);
            CHECK_REL(m.stiffness, 7250, 1e-6);
        }
        CHECK_EQ(dem_moldyn_add(w, &m), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error(w), "make an empty one with dem_moldyn_desc");
        {                                        /* filled in by hand: found before any is added */
            const dem_world_desc desc = dem_moldyn_desc(&m);
            dem_world *fresh = dem_world_create(&desc);
            m.grains[14*4 + 12] = -1;
            CHECK_EQ(dem_moldyn_add(fresh, &m), DEM_ERROR_ARGUMENT);
            CHECK_STR(dem_world_error(fresh), "grain 4 has radius -1");
            m.grains[14*4 + 12] = 1;
            m.density = 0;
            CHECK_EQ(dem_moldyn_add(fresh, &m), DEM_ERROR_ARGUMENT);
            CHECK_STR(dem_world_error(fresh), "control.rho is 0");
            CHECK_EQ(dem_bodies_get(fresh).count, 0);
            m.density = 2000;
            CHECK_EQ(dem_moldyn_add(fresh, &m), DEM_OK);   /* the world is as it was */
            dem_world_destroy(fresh);
        }
        dem_moldyn_free(&m);
        CHECK_EQ(dem_moldyn_read(w, "build/tmp/none.cin", 0, 0, &m), DEM_ERROR_FILE);
        CHECK_EQ(m.grain_count, 0);
        dem_world_destroy(w);
    }

    TEST(".str refuses another number of bodies than its head says, and what was read outlives its world") {
        static const char path[] = "build/tmp/count.str";
        dem_world *w = any_world();
        dem_moldyn m = DEM_MOLDYN;
        parse(w, &m, DEM_MOLDYN_CONTROL, cin);
        parse(w, &m, DEM_MOLDYN_PARTICLES, pin);
        dem_world_destroy(w);
        {
            const dem_world_desc desc = dem_moldyn_desc(&m);
            w = dem_world_create(&desc);
        }
        CHECK_EQ(dem_moldyn_add(w, &m), DEM_OK);
        CHECK_EQ(dem_moldyn_take(w, &m), DEM_OK);
        remove(path);
        CHECK_EQ(dem_str_append(w, path, 0.1, 2), DEM_OK);
        CHECK_EQ(dem_str_append(w, path, 0.1, 2), DEM_OK);
        dem_body_remove(w, dem_bodies_id(w, 0));
        CHECK_EQ(dem_str_append(w, path, 0.1, 2), DEM_ERROR_FORMAT);
        CHECK_STR(dem_world_error(w), "is not of 5 bodies");
        dem_world_destroy(w);
        dem_moldyn_free(&m);
        remove(path);
    }

    return test_end();
}
