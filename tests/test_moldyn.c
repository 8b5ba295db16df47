/* MOLDYN's files: the appendix's own lines, a scene of three files run and written, what is refused. */
#define DEM_IMPLEMENTATION
#include "../dem.h"
#include "../examples/moldyn.h"
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
static dem_world *world_of(const moldyn *m) {
    const dem_world_desc desc = moldyn_desc(m);
    return dem_world_create(&desc);
}
static dem_result parse(moldyn *m, moldyn_file file, const char *text) {
    return moldyn_parse(m, "text", file, text, strlen(text));
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
        moldyn m = MOLDYN;
        CHECK_EQ(parse(&m, MOLDYN_CONTROL, cin), DEM_OK);
        CHECK_EQ(parse(&m, MOLDYN_PARTICLES, pin), DEM_OK);
        CHECK_EQ(parse(&m, MOLDYN_WALLS, win), DEM_OK);
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
        moldyn_free(&m);
        CHECK_EQ(m.grain_count, 0);
    }

    TEST("a scene given by three files runs, is written, read back, and goes on the same") {
        static const char small[] =
            "times.t0 2\ntimes.tend 2.4\ntimes.dt 2e-5\ncontrol.grav -9.81\ncontrol.rho 2500\ncontrol.mue_s .3\n"
            "control.mue_d .2\nsd.stiff_lo 2000\nsd.stiff_k_un 3000\nsd.stiff_adh -100\n"
            "sd.damp_wall 0.5\nsd.damp_particle 0.1\n";
        static const char grains[] =
            "4\n.05 .05 .02 0 0 0 0 0 0 0 0 0 .01 1\n.05 .052 .045 0 .1 0 0 0 0 0 0 0 .012 1\n"
            ".1 .1 .01 0 0 0 0 0 0 0 0 0 .012 0\n.1 .105 .06 0 0 0 0 0 0 0 5 0 .01 1\n";
        static const char *path[] = {"build/tmp/m.cin", "build/tmp/m.pin", "build/tmp/m.win",
                                     "build/tmp/n.cin", "build/tmp/n.pin", "build/tmp/n.win"};
        dem_world *a, *b;
        moldyn m = MOLDYN, n = MOLDYN;
        dem_bodies ba, bb;
        int i, k;
        save(path[0], small); save(path[1], grains); save(path[2], win);
        CHECK_EQ(moldyn_read(&m, path[0], path[1], path[2]), DEM_OK);
        CHECK_EQ((int)moldyn_desc(&m).normal_law, (int)DEM_NORMAL_HYSTERETIC);
        a = world_of(&m);
        CHECK_EQ(moldyn_add(&m, a), DEM_OK);
        CHECK_EQ(dem_world_run(a, m.end - m.start, 0, 0), DEM_OK);
        for (k = 0; k < 4; k++) {                /* they lie on the walls' surfaces, 1.5 mm inside */
            const dem_body_state s = scene_state(a, dem_bodies_id(a, k));
            CHECK(s.fixed || (double)(s.position.z - s.radius) > 0.001 - 0.0005);
        }
        CHECK_EQ(moldyn_take(&m, a), DEM_OK);
        CHECK_REL(m.start, 2.4, 1e-5);           /* half a step */
        CHECK_EQ(moldyn_take(&m, a), DEM_OK);    /* once more is no later */
        CHECK_NEAR(m.start, 2 + dem_world_time(a), 0);
        CHECK_EQ(moldyn_write(&m, path[3], path[4], path[5]), DEM_OK);
        CHECK_EQ(moldyn_read(&n, path[3], path[4], path[5]), DEM_OK);
        CHECK_EQ(n.grain_count, 4);
        CHECK(memcmp(n.grains, m.grains, 14*4*sizeof(dem_real)) == 0);
        CHECK(memcmp(n.walls, m.walls, 6*6*sizeof(dem_real)) == 0);
        CHECK(n.start >= m.start && n.start <= m.start);
        CHECK_REL(n.stiffness_adhesion, m.stiffness_adhesion, 1e-6);
        b = world_of(&n);
        CHECK_EQ(moldyn_add(&n, b), DEM_OK);
        CHECK_NEAR(dem_world_time(b), 0, 0);     /* a world's clock begins at 0 */
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
        CHECK_EQ(moldyn_take(&n, b), DEM_OK);
        CHECK_NEAR(n.start, m.start + dem_world_time(b), 0);
        moldyn_free(&m);
        moldyn_free(&n);
        dem_world_destroy(a);
        dem_world_destroy(b);
        for (i = 0; i < 6; i++) remove(path[i]);
    }

    TEST("damping and restitution of .cin come out in the bounce: sd.e between grains, damp_wall at "
         "walls") {
        dem_world *w;
        moldyn m = MOLDYN;
        dem_coefficients c;
        parse(&m, MOLDYN_CONTROL, cin);
        parse(&m, MOLDYN_WALLS, win);
        /* unloads as it loads */
        CHECK_EQ((int)moldyn_desc(&m).normal_law, (int)DEM_NORMAL_LINEAR);
        w = world_of(&m);
        CHECK_EQ(moldyn_add(&m, w), DEM_OK);
        CHECK_EQ(dem_coefficients_get(w, m.grain_material, m.grain_material, DEM_R(0.15), DEM_R(0.15),
                                      &c), DEM_OK);
        CHECK_REL(exp(-3.14159265*(double)c.damping_ratio/sqrt(1 - (double)c.damping_ratio*
                  (double)c.damping_ratio)), 0.27, 1e-5);
        CHECK_EQ(dem_coefficients_get(w, m.grain_material, m.wall_material, DEM_R(0.15), 0, &c),
                 DEM_OK);
        CHECK_REL(c.cn, 0.38, 1e-6);
        moldyn_free(&m);
        dem_world_destroy(w);
    }

    TEST("files in a plane have 8 and 4 columns, gravity along y, and make a planar world") {
        dem_world *w;
        moldyn m = MOLDYN;
        dem_body_state s;
        parse(&m, MOLDYN_CONTROL, cin);
        CHECK_EQ(parse(&m, MOLDYN_PARTICLES, "2\n0 1 .5 0 0 2 .1 1\n3 0 0 0 0 0 .1 0\n"),
                 DEM_OK);
        CHECK_EQ(parse(&m, MOLDYN_WALLS, "1 .02\n0 1 0 0\n"), DEM_OK);
        CHECK_EQ(m.planar, 1);
        m.damping_wall = 100;                    /* a disc of .6 kg: at rest soon */
        w = world_of(&m);
        CHECK_EQ(moldyn_add(&m, w), DEM_OK);
        s = scene_state(w, dem_bodies_id(w, 0));
        CHECK_NEAR(s.position.y, 1, 1e-6);
        CHECK_NEAR(s.spin.z, 2, 1e-6);
        CHECK_NEAR(s.velocity.x, 0.5, 1e-6);
        CHECK_EQ(dem_world_run(w, 2, 0, 0), DEM_OK);
        s = scene_state(w, dem_bodies_id(w, scene_state(w, dem_bodies_id(w, 0)).fixed));
        CHECK_NEAR(s.position.y, 0.11, 0.003);   /* on the wall's surface, .01 above its middle */
        moldyn_free(&m);
        dem_world_destroy(w);
    }

    TEST(".xb and .str files look as the appendix shows them") {
        static const char xb[] = "build/tmp/a.xb", str[] = "build/tmp/a.str";
        const dem_box box = dem_box_make(0, 0, 0, DEM_R(0.171), DEM_R(0.171), 0);
        dem_world *w;
        moldyn m = MOLDYN;
        char text[2000];
        remove(xb);
        remove(str);
        parse(&m, MOLDYN_CONTROL, cin);
        parse(&m, MOLDYN_PARTICLES, "1\n.05 .12 0 0 0 0 .004 1\n");
        parse(&m, MOLDYN_WALLS, "1 .003\n0 1 0 -5\n");
        w = world_of(&m);
        moldyn_add(&m, w);
        CHECK_EQ(moldyn_xb_append(&m, w, xb, box), DEM_OK);
        CHECK_EQ(moldyn_str_append(&m, w, str, 0.01, 2, m.planes, m.wall_count), DEM_OK);
        dem_world_step(w, 1);
        CHECK_EQ(moldyn_xb_append(&m, w, xb, box), DEM_OK);
        CHECK_EQ(moldyn_str_append(&m, w, str, 0.01, 2, m.planes, m.wall_count), DEM_OK);
        load(xb, text, sizeof text);
        /* the second frame has the appendix's own -0.000098 m/s of one step of 1e-5 s */
        CHECK(strcmp(text, "1 0 0.000000 0.000000 0.171000 0.171000\n"
                     "0.050000 0.120000 0.000000 0.000000 0.004000 0.000000\n"
                     "1 1e-05 0.000000 0.000000 0.171000 0.171000\n"
                     "0.050000 0.120000 0.000000 -0.000098 0.004000 0.000000\n") == 0);
        load(str, text, sizeof text);
        CHECK_STR(text, "0.01 2 2\n1 0 0 0 1 0 0 0 1 0.050000 0.120000 0.000000\n");
        CHECK_EQ((int)(strstr(text, "0.120000") != strstr(text, "0.01")), 1);
        moldyn_free(&m);
        dem_world_destroy(w);
        remove(xb);
        remove(str);
    }

    TEST("malformed files are refused with line and reason, and what was read before stays") {
        static const struct { moldyn_file file; const char *text, *says; } rows[] = {
            {MOLDYN_CONTROL, "", "a line with times.tend is expected"},
            {MOLDYN_CONTROL, "times.tend 1\ntimes.ende 2\n", "line 2: found 'times.ende'"},
            {MOLDYN_CONTROL, "times.tend 1\ntimes.tend 2\n", "each once"},
            {MOLDYN_CONTROL, "times.dt 0\n", "line 1: found '0' where the value of times.dt"},
            {MOLDYN_CONTROL, "sd.stiff_adh 3\n", "the value of sd.stiff_adh"},
            {MOLDYN_CONTROL, "times.dt nan\n", "found 'nan'"},
            {MOLDYN_CONTROL, "times.dt 1 2\n", "one value to a key"},
            {MOLDYN_CONTROL, "times.tend 1\ntimes.dt 1\ncontrol.rho 1\nsd.stiff_lo 1\n"
             "control.mue_d .4\ncontrol.mue_s .3\n", "control.mue_s of at least"},
            {MOLDYN_PARTICLES, "", "the number of grains"},
            {MOLDYN_PARTICLES, "-1\n", "the number of grains"},
            {MOLDYN_PARTICLES, "999999999\n1 2 3\n", "cut short"},
            {MOLDYN_PARTICLES, "1\n0 0 0 0 0 0 0 0 0 0 0 0 .1\n", "14 numbers"},
            {MOLDYN_PARTICLES, "1\n0 0 0 0 0 0 0 0 0 0 0 0 .1 1 7\n", "14 numbers"},
            {MOLDYN_PARTICLES, "1\n0 0 0 0 0 0 0 0 0 0 0 0 0 1\n", "a radius > 0"},
            {MOLDYN_PARTICLES, "1\n0 0 0 0 0 0 0 0 0 0 0 0 .1 2\n", "1 (moves)"},
            {MOLDYN_PARTICLES, "2\n0 0 0 0 0 0 .1 1\n0 0 0 0 0 0 0 0 0 0 0 0 .1 1\n",
             "line 3: found '0.1' where row 2 of 2"},
            {MOLDYN_PARTICLES, "1\n0 0 0 0 0 0 0 0 0 0 0 0 .1 1\n0\n", "more rows"},
            {MOLDYN_PARTICLES, "1\n0 0 x 0 0 0 0 0 0 0 0 0 .1 1\n", "line 2: found 'x'"},
            {MOLDYN_WALLS, "1\n", "the thickness"},
            {MOLDYN_WALLS, "1 -1\n1 0 0 0 0 0\n", "the thickness"},
            {MOLDYN_WALLS, "1 .1\n0 0 0 0 0 0\n", "a normal that is not 0"},
            {MOLDYN_WALLS, "1 .1\n1 0 0 0\n", "as the other file"}};
        dem_world *w = any_world();
        moldyn m = MOLDYN;
        size_t i;
        parse(&m, MOLDYN_CONTROL, cin);
        parse(&m, MOLDYN_PARTICLES, pin);
        for (i = 0; i < sizeof rows/sizeof *rows; i++) {
            CHECK_EQ(parse(&m, rows[i].file, rows[i].text), DEM_ERROR_FORMAT);
            if (rows[i].says[0]) CHECK_STR(m.error, i == 15 ? "row 2 of 2" : rows[i].says);
            CHECK_EQ(m.grain_count, 6);
            CHECK_REL(m.stiffness, 7250, 1e-6);
        }
        CHECK_EQ(moldyn_add(&m, w), DEM_ERROR_ARGUMENT);
        CHECK_STR(m.error, "make an empty one with moldyn_desc");
        {                                        /* filled in by hand: found before any is added */
            dem_world *fresh = world_of(&m);
            m.grains[14*4 + 12] = -1;
            CHECK_EQ(moldyn_add(&m, fresh), DEM_ERROR_ARGUMENT);
            CHECK_STR(m.error, "grain 4 has radius -1");
            m.grains[14*4 + 12] = DEM_R(1e-15)*DEM_R(1e-12);
            if (sizeof(dem_real) > 4) m.grains[14*4 + 12] = DEM_R(1e-110);
            CHECK_EQ(moldyn_add(&m, fresh), DEM_ERROR_ARGUMENT);
            CHECK_STR(m.error, "a mass too small");
            m.grains[14*4 + 12] = 1;
            m.density = 0;
            CHECK_EQ(moldyn_add(&m, fresh), DEM_ERROR_ARGUMENT);
            CHECK_STR(m.error, "control.rho is 0");
            CHECK_EQ(dem_bodies_get(fresh).count, 0);
            m.density = 2000;
            CHECK_EQ(moldyn_add(&m, fresh), DEM_OK);   /* the world is as it was */
            dem_world_destroy(fresh);
        }
        moldyn_free(&m);
        CHECK_EQ(moldyn_read(&m, "build/tmp/none.cin", 0, 0), DEM_ERROR_FILE);
        CHECK_STR(m.error, "moldyn_read: cannot read build/tmp/none.cin");
        CHECK_EQ(m.grain_count, 0);
        dem_world_destroy(w);
    }

    TEST(".str refuses another number of bodies than its head says, and what was read outlives its world") {
        static const char path[] = "build/tmp/count.str";
        dem_world *w;
        moldyn m = MOLDYN;
        parse(&m, MOLDYN_CONTROL, cin);
        parse(&m, MOLDYN_PARTICLES, pin);
        w = world_of(&m);
        CHECK_EQ(moldyn_add(&m, w), DEM_OK);
        CHECK_EQ(moldyn_take(&m, w), DEM_OK);
        dem_world_destroy(w);
        w = world_of(&m);
        CHECK_EQ(moldyn_add(&m, w), DEM_OK);
        remove(path);
        CHECK_EQ(moldyn_str_append(&m, w, path, 0.1, 2, m.planes, m.wall_count), DEM_OK);
        CHECK_EQ(moldyn_str_append(&m, w, path, 0.1, 2, m.planes, m.wall_count), DEM_OK);
        dem_body_remove(w, dem_bodies_id(w, 0));
        CHECK_EQ(moldyn_str_append(&m, w, path, 0.1, 2, m.planes, m.wall_count), DEM_ERROR_FORMAT);
        CHECK_STR(m.error, "is not of 5 bodies");
        dem_world_destroy(w);
        moldyn_free(&m);
        remove(path);
    }

    TEST("null pointers, walls that are gone and folders that are missing are refused with a sentence, "
         "and a file that cannot be replaced stays whole") {
        static const char path[] = "build/tmp/whole.pin", taken[] = "build/tmp/whole.pin.tmp";
        dem_world *w = any_world();
        const dem_box box = dem_box_make(0, 0, 0, 1, 1, 1);
        moldyn m = MOLDYN;
        dem_wall wall;
        char text[100];
        wall.id = 7;
        CHECK_EQ(moldyn_read(0, 0, 0, 0), DEM_ERROR_ARGUMENT);
        CHECK_EQ(moldyn_parse(0, 0, MOLDYN_CONTROL, 0, 0), DEM_ERROR_ARGUMENT);
        CHECK_EQ(moldyn_desc(0).planar, 0);
        CHECK_EQ(moldyn_add(0, w), DEM_ERROR_ARGUMENT);
        CHECK_EQ(moldyn_take(0, w), DEM_ERROR_ARGUMENT);
        CHECK_EQ(moldyn_write(0, 0, 0, 0), DEM_ERROR_ARGUMENT);
        CHECK_EQ(moldyn_xb_append(0, w, path, box), DEM_ERROR_ARGUMENT);
        CHECK_EQ(moldyn_str_append(0, w, path, 1, 1, 0, 0), DEM_ERROR_ARGUMENT);
        moldyn_free(0);
#define REFUSES(call, says) do { m.error[0] = 0; CHECK_EQ((call), DEM_ERROR_ARGUMENT); \
    CHECK_STR(m.error, says); } while (0)
        REFUSES(moldyn_read(&m, 0, 0, 0), "moldyn_read: cin is null");
        REFUSES(moldyn_parse(&m, 0, MOLDYN_CONTROL, 0, 5), "data is null");
        REFUSES(moldyn_parse(&m, 0, (moldyn_file)3, "", 0), "file is 3");
        REFUSES(moldyn_add(&m, 0), "world is null");
        REFUSES(moldyn_take(&m, 0), "world is null");
        REFUSES(moldyn_xb_append(&m, 0, path, box), "world is null");
        REFUSES(moldyn_xb_append(&m, w, 0, box), "path is null");
        REFUSES(moldyn_str_append(&m, 0, path, 1, 1, 0, 0), "world is null");
        REFUSES(moldyn_str_append(&m, w, 0, 1, 1, 0, 0), "path is null");
        REFUSES(moldyn_str_append(&m, w, path, 1, -1, 0, 0), "frames -1");
        REFUSES(moldyn_str_append(&m, w, path, 1, 1, 0, 1), "wall_count is 1");
        REFUSES(moldyn_str_append(&m, w, path, 1, 1, &wall, 1), "walls[0] has id 7");
        parse(&m, MOLDYN_CONTROL, cin);
        m.grain_count = 1;
        REFUSES(moldyn_write(&m, 0, path, 0), "as many rows");
        m.grain_count = 0;
#undef REFUSES
        CHECK_EQ(moldyn_xb_append(&m, w, "build/tmp/none/a.xb", box), DEM_ERROR_FILE);
        CHECK_STR(m.error, "cannot append to build/tmp/none/a.xb");
        CHECK_EQ(moldyn_write(&m, "build/tmp/none/a.cin", 0, 0), DEM_ERROR_FILE);
        CHECK_STR(m.error, "cannot write build/tmp/none/a.cin");
        save(path, "old\n");
        CHECK_EQ(moldyn_write(&m, 0, path, 0), DEM_OK);
        load(path, text, sizeof text);
        CHECK_STR(text, "0\n");
        load(taken, text, sizeof text);
        CHECK_EQ(text[0], 0);                    /* no temporary file is left */
        parse(&m, MOLDYN_PARTICLES, pin);
        m.grains[12] = 0;
        CHECK_EQ(moldyn_write(&m, 0, path, 0), DEM_ERROR_ARGUMENT);
        load(path, text, sizeof text);
        CHECK(strcmp(text, "0\n") == 0);
        moldyn_free(&m);
        dem_world_destroy(w);
        remove(path);
    }

    return test_end();
}
