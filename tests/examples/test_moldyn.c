/* MOLDYN's files: the appendix's own lines, a scene of three files run and written, polygons as grains and
   walls, what is refused. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../../examples/moldyn.h"
#include "../test.h"
#include "../scene.h"

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
/* a triangle and, clockwise, an L; two Ls (one of twice its size), a disc, a triangle that stands, one that moves,
   whose radius times .91 over its radius is not .91, in either precision */
static const char polygon_pin[] =
    "polygons 2\n3\n0 0\n.02 0\n0 .01\n"
    "6\n0 0\n0 .02   # clockwise\n.006 .02\n.006 .006\n.02 .006\n.02 0\n"
    "5\n.01 .02 .1 0 .3 1 .91 1 1\n-.02 .03 0 0 0 0 .005 1 0\n.05 .1 0 0 .5 0 2 1 2\n"
    "-.06 .05 0 0 2.5 0 1.3 0 1\n.1 .02 0 0 9 3 1 1 2\n";
/* a floor and a tooth, and an open chute */
static const char polygon_win[] =
    "polygons 2\n4\n-1 -.1\n1 -.1\n1 0\n-1 0\n3\n.02 0.0001\n.06 0.0001\n.04 .03\n"
    "chains 1\n3\n-.1 .1\n-.08 .05\n-.08 .02\n1 .003\n1 0 -.5 0\n";

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

    TEST("a scene of three files runs, is written, read back, and continues alike") {
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
            const dem_body_state s = scene_state(a, dem_body_id_get(a, k));
            CHECK(s.fixed || (double)(s.position.z - s.radius) > 0.001 - 0.0005);
        }
        CHECK_EQ(moldyn_take(&m, a), DEM_OK);
        CHECK_REL(m.start, 2.4, 1e-5);           /* half a step */
        CHECK_EQ(moldyn_take(&m, a), DEM_OK);    /* once more is no later */
        CHECK_NEAR(m.start, 2 + dem_world_time_get(a), 0);
        CHECK_EQ(moldyn_write(&m, path[3], path[4], path[5]), DEM_OK);
        CHECK_EQ(moldyn_read(&n, path[3], path[4], path[5]), DEM_OK);
        CHECK_EQ(n.grain_count, 4);
        CHECK(memcmp(n.grains, m.grains, 14*4*sizeof(dem_real)) == 0);
        CHECK(memcmp(n.walls, m.walls, 6*6*sizeof(dem_real)) == 0);
        CHECK(n.start >= m.start && n.start <= m.start);
        CHECK_REL(n.stiffness_adhesion, m.stiffness_adhesion, 1e-6);
        b = world_of(&n);
        CHECK_EQ(moldyn_add(&n, b), DEM_OK);
        CHECK_NEAR(dem_world_time_get(b), 0, 0);     /* a world's clock begins at 0 */
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
        CHECK_NEAR(n.start, m.start + dem_world_time_get(b), 0);
        moldyn_free(&m);
        moldyn_free(&n);
        dem_world_destroy(a);
        dem_world_destroy(b);
        for (i = 0; i < 6; i++) remove(path[i]);
    }

    TEST("damping and restitution of .cin are those of the bounce: sd.e between grains, damp_wall at walls") {
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

    TEST("planar files have 8 and 4 columns and gravity along y, and make a planar world") {
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
        s = scene_state(w, dem_body_id_get(w, 0));
        CHECK_NEAR(s.position.y, 1, 1e-6);
        CHECK_NEAR(s.spin.z, 2, 1e-6);
        CHECK_NEAR(s.velocity.x, 0.5, 1e-6);
        CHECK_EQ(dem_world_run(w, 2, 0, 0), DEM_OK);
        s = scene_state(w, dem_body_id_get(w, scene_state(w, dem_body_id_get(w, 0)).fixed));
        CHECK_NEAR(s.position.y, 0.11, 0.003);   /* on the wall's surface, .01 above its middle */
        moldyn_free(&m);
        dem_world_destroy(w);
    }

    TEST(".xb and .str files have the format of the appendix") {
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

    TEST("malformed files are rejected with line and reason, and leave earlier data unchanged") {
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

    TEST(".str is rejected for a body count unlike its head's, and its data outlives the world") {
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
        dem_body_remove(w, dem_body_id_get(w, 0));
        CHECK_EQ(moldyn_str_append(&m, w, path, 0.1, 2, m.planes, m.wall_count), DEM_ERROR_FORMAT);
        CHECK_STR(m.error, "is not of 5 bodies");
        dem_world_destroy(w);
        moldyn_free(&m);
        remove(path);
    }

    TEST("null pointers, removed walls and missing folders are rejected, and a file that cannot be replaced stays "
         "intact") {
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
        save(taken, "mine\n");                   /* the temporary name is one that no file has */
        CHECK_EQ(moldyn_write(&m, 0, path, 0), DEM_OK);
        load(path, text, sizeof text);
        CHECK_STR(text, "0\n");
        load(taken, text, sizeof text);
        CHECK_STR(text, "mine\n");
        remove(taken);
        parse(&m, MOLDYN_PARTICLES, pin);
        m.grains[12] = 0;
        CHECK_EQ(moldyn_write(&m, 0, path, 0), DEM_ERROR_ARGUMENT);
        load(path, text, sizeof text);
        CHECK(strcmp(text, "0\n") == 0);
        moldyn_free(&m);
        dem_world_destroy(w);
        remove(path);
    }

    TEST("polygons: grains, parts and chains survive reading, running, writing and reading with the same numbers") {
        static const char *path[] = {"build/tmp/p.cin", "build/tmp/p.pin", "build/tmp/p.win",
                                     "build/tmp/q.cin", "build/tmp/q.pin", "build/tmp/q.win"};
        char first[3000], again[3000];
        dem_world *a, *b;
        moldyn m = MOLDYN, n = MOLDYN;
        dem_body_state s, r;
        dem_real *before;
        int i, turned = 0;
        save(path[0], "times.tend .1\ntimes.dt 5e-6\ncontrol.grav -9.81\ncontrol.rho 2500\ncontrol.mue_d .4\n"
             "sd.stiff_lo 1e6\nsd.damp_wall 300\nsd.damp_particle 200\n");
        save(path[1], polygon_pin);
        save(path[2], polygon_win);
        CHECK_EQ(moldyn_read(&m, path[0], path[1], path[2]), DEM_OK);
        CHECK_EQ(m.planar, 1);
        CHECK_EQ(m.polygons.count, 2);
        CHECK_EQ(m.polygons.ends[1], 9);         /* a triangle and an L */
        CHECK_EQ(m.kinds[0] + 10*m.kinds[1] + 100*m.kinds[2] + 1000*m.kinds[3] + 10000*m.kinds[4], 21201);
        CHECK_EQ(m.parts.count*10 + m.chains.count, 21);
        a = world_of(&m);
        CHECK_EQ(moldyn_add(&m, a), DEM_OK);
        before = (dem_real *)malloc(14*5*sizeof *before);
        memcpy(before, m.grains, 14*5*sizeof *before);
        CHECK_EQ(moldyn_take(&m, a), DEM_OK);    /* at once: as they were, to the last bit */
        CHECK(memcmp(before, m.grains, 14*5*sizeof *before) == 0);
        CHECK_EQ(dem_world_step(a, 1), DEM_OK);  /* a turn of 5e-6 rad is one */
        CHECK_EQ(moldyn_take(&m, a), DEM_OK);
        CHECK_NEAR((double)m.grains[8] - (double)before[8], 5e-6, sizeof(dem_real) == 8 ? 1e-12 : 1e-6);
        CHECK_EQ(dem_world_run(a, 0.1, 0, 0), DEM_OK);
        CHECK_EQ(moldyn_take(&m, a), DEM_OK);
        for (i = 0; i < 5; i++) {
            CHECK(m.grains[14*i + 12] >= before[14*i + 12] && m.grains[14*i + 12] <= before[14*i + 12]);
            turned += m.grains[14*i + 8] < before[14*i + 8] || m.grains[14*i + 8] > before[14*i + 8];
            CHECK(m.grains[14*i + 1] > -DEM_R(0.001));
        }
        CHECK_EQ(turned, 2);                     /* not the disc, the one that stands, the one that falls */
        CHECK_EQ(moldyn_write(&m, path[3], path[4], path[5]), DEM_OK);
        CHECK_EQ(moldyn_read(&n, path[3], path[4], path[5]), DEM_OK);
        CHECK_EQ(n.grain_count, 5);
        CHECK(memcmp(n.grains, m.grains, 14*5*sizeof *before) == 0);
        CHECK(memcmp(n.kinds, m.kinds, 5*sizeof *n.kinds) == 0);
        CHECK(memcmp(n.polygons.corners, m.polygons.corners, 18*sizeof *before) == 0);
        CHECK(memcmp(n.parts.corners, m.parts.corners, 14*sizeof *before) == 0);
        CHECK(memcmp(n.chains.corners, m.chains.corners, 6*sizeof *before) == 0);
        b = world_of(&n);
        CHECK_EQ(moldyn_add(&n, b), DEM_OK);
        for (i = 0; i < 5; i++) {
            s = scene_state(a, m.bodies[i]);
            r = scene_state(b, n.bodies[i]);
            CHECK(memcmp(&s.position, &r.position, sizeof s.position) == 0);
            CHECK(memcmp(&s.velocity, &r.velocity, sizeof s.velocity) == 0);
            CHECK(memcmp(&s.mass, &r.mass, sizeof s.mass) == 0);
            CHECK(memcmp(&s.spin, &r.spin, sizeof s.spin) == 0);
            if (s.shape.id)                      /* from angle to quaternion and back: a few last bits */
                CHECK_NEAR(s.orientation.w*r.orientation.w + s.orientation.z*r.orientation.z, 1,
                           sizeof(dem_real) == 8 ? 1e-14 : 1e-6);
        }
        CHECK_EQ(moldyn_take(&n, b), DEM_OK);
        CHECK(memcmp(n.grains, m.grains, 14*5*sizeof *before) == 0);
        CHECK_EQ(moldyn_write(&n, path[0], path[1], path[2]), DEM_OK);
        for (i = 0; i < 3; i++) {
            load(path[i], first, sizeof first);
            load(path[3 + i], again, sizeof again);
            CHECK(first[0] && strcmp(first, again) == 0);
        }
        dem_body_remove(b, n.bodies[1]);         /* those behind it stay what they are */
        CHECK_EQ(moldyn_take(&n, b), DEM_OK);
        CHECK_EQ(n.grain_count, 4);
        CHECK_EQ(n.kinds[1]*10 + n.kinds[2], 21);
        CHECK(memcmp(n.grains + 14, m.grains + 28, 14*3*sizeof *before) == 0);
        free(before);
        moldyn_free(&m);
        moldyn_free(&n);
        dem_world_destroy(a);
        dem_world_destroy(b);
        for (i = 0; i < 6; i++) remove(path[i]);
    }

    TEST("polygons: mass, centre and moment are those of dem_shape_polygon_add, scaled; position and angle are the "
         "centre's") {
        const double area = 2.04e-4, X = (1.2e-4*.01 + .84e-4*.003)/area, Y = (1.2e-4*.003 + .84e-4*.013)/area;
        const double fine = sizeof(dem_real) == 8 ? 1e-12 : 1e-5;
        dem_world *w;
        moldyn m = MOLDYN;
        moldyn_measure s;
        dem_shape_info info;
        dem_body_state body;
        dem_shape shape;
        dem_vec3 e;
        parse(&m, MOLDYN_CONTROL, cin);
        CHECK_EQ(parse(&m, MOLDYN_PARTICLES, polygon_pin), DEM_OK);
        s = moldyn_measure_of(m.polygons.corners + 6, 6);
        w = world_of(&m);
        CHECK_EQ(moldyn_add(&m, w), DEM_OK);
        shape = dem_shape_polygon_add(w, 6, m.polygons.corners + 6);
        CHECK_EQ(dem_shape_get(w, shape, &info), DEM_OK);
        CHECK_REL(s.area, area, fine);
        CHECK_REL(s.area, (double)info.volume, fine);
        CHECK_NEAR(s.middle[0], X, fine);
        CHECK_NEAR(s.middle[0], (double)info.centre.x, fine);
        CHECK_NEAR(s.middle[1], Y, fine);
        CHECK_NEAR(s.middle[1], (double)info.centre.y, fine);
        CHECK_REL(s.second, (double)info.inertia.z, fine);
        CHECK_REL(hypot(s.radius, 2*sqrt(area/3.14159265358979324)/3), (double)info.radius, fine);   /* of the prism */
        body = scene_state(w, m.bodies[2]);      /* the L, twice as large, turned by .5 */
        CHECK_REL((double)body.mass, 20*area*4, fine);
        CHECK_REL((double)body.moments.z, 20*s.second*16, fine);
        CHECK_NEAR((double)body.position.x, 0.05, fine);
        CHECK_NEAR((double)body.position.y, 0.1, fine);
        e = dem_quat_rotate(body.orientation, at(1, 0, 0));
        CHECK_NEAR((double)e.x, cos(0.5), fine);
        CHECK_NEAR((double)e.y, sin(0.5), fine);
        {                                        /* far off: the corners' differences count */
            dem_real far[6] = {1000000, 1000000, 1000001, 1000000, 1000000, 1000001};
            s = moldyn_measure_of(far, 3);
            CHECK_REL(s.area, 0.5, 1e-12);
            CHECK_REL(s.second, 1.0/18, 1e-12);  /* of b h (b2 + h2)/36 */
        }
        moldyn_free(&m);
        dem_world_destroy(w);
    }

    TEST("an L rests on a polygonal wall's edge with its centre of mass 1 mm inside, and topples 1 mm outside") {
        int beyond;
        for (beyond = 0; beyond < 2; beyond++) {
            moldyn m = MOLDYN;
            dem_world *w;
            char text[500];
            double angle;
            CHECK_EQ(parse(&m, MOLDYN_CONTROL, "times.tend 1\ntimes.dt 1e-6\ncontrol.grav -9.81\ncontrol.rho 2500\n"
                           "control.mue_d .5\nsd.stiff_lo 1e7\nsd.e .3\n"), DEM_OK);
            snprintf(text, sizeof text, "polygons 1\n6\n0 0\n.02 0\n.02 .006\n.006 .006\n.006 .02\n0 .02\n"
                     "1\n%s .0071176 0 0 0 0 1 1 1\n", beyond ? ".001" : "-.001");
            CHECK_EQ(parse(&m, MOLDYN_PARTICLES, text), DEM_OK);
            CHECK_EQ(parse(&m, MOLDYN_WALLS, "polygons 1\n4\n-.1 -.1\n0 -.1\n0 0\n-.1 0\n0 0\n"), DEM_OK);
            w = world_of(&m);
            CHECK_EQ(moldyn_add(&m, w), DEM_OK);
            CHECK_EQ(dem_world_run(w, 0.15, 0, 0), DEM_OK);
            CHECK_EQ(moldyn_take(&m, w), DEM_OK);
            angle = (double)m.grains[8];
            if (beyond) CHECK(angle < -1);       /* clockwise, off the edge */
            else {                               /* 1.5 mrad at most: the ground is elastic */
                CHECK_NEAR(angle, 0, 3e-3);
                CHECK_NEAR((double)m.grains[0], -0.001, 5e-5);
                CHECK_NEAR((double)m.grains[1], 0.0071176, 1e-5);
            }
            moldyn_free(&m);
            dem_world_destroy(w);
        }
    }

    TEST("an L that hits a polygonal wall's face or tip elastically keeps its energy, better at smaller steps") {
        static const char *const walls[] = {"1 0\n0 1 0 0\n", "polygons 1\n4\n-.1 -.1\n.1 -.1\n.1 0\n-.1 0\n0 0\n",
                                            "polygons 1\n3\n-.1 -.1\n.1 -.1\n0.002 0\n0 0\n"};
        double worst[2], up[3];
        int tip, k, step;
        for (tip = 0; tip < 3; tip++) {
            for (k = 0; k < 2; k++) {
                moldyn m = MOLDYN;
                dem_world_desc desc;
                dem_world *w;
                double before = 0;
                char text[500];
                snprintf(text, sizeof text, "times.tend 1\ntimes.dt %s\ncontrol.rho 2500\nsd.stiff_lo 1e6\n",
                         k ? "1e-6" : "4e-6");
                CHECK_EQ(parse(&m, MOLDYN_CONTROL, text), DEM_OK);
                CHECK_EQ(parse(&m, MOLDYN_PARTICLES, "polygons 1\n6\n0 0\n.02 0\n.02 .006\n.006 .006\n.006 .02\n"
                               "0 .02\n1\n0 .03 0 -1 .7 20 1 1 1\n"), DEM_OK);
                CHECK_EQ(parse(&m, MOLDYN_WALLS, walls[tip]), DEM_OK);
                desc = moldyn_desc(&m);
                desc.ledger = 1;
                w = dem_world_create(&desc);
                CHECK_EQ(moldyn_add(&m, w), DEM_OK);
                for (worst[k] = step = 0; step < 200; step++) {
                    dem_ledger l;
                    CHECK_EQ(dem_world_run(w, 2e-4, 0, 0), DEM_OK);
                    l = dem_ledger_get(w);
                    if (step == 0) before = (double)(l.kinetic + l.rotational + l.elastic);
                    worst[k] = fmax(worst[k], fabs((double)(l.kinetic + l.rotational + l.elastic)/before - 1));
                }
                up[tip] = (double)scene_state(w, m.bodies[0]).velocity.y;
                CHECK(up[tip] > 0.1);
                moldyn_free(&m);
                dem_world_destroy(w);
            }
            CHECK_NEAR(worst[0], 0, sizeof(dem_real) == 8 ? 1e-5 : 1e-3);
            if (sizeof(dem_real) == 8) CHECK(worst[1] < worst[0]/10);
        }
        /* the face of a part and a plane are one wall to it */
        CHECK_NEAR(up[0], up[1], sizeof(dem_real) == 8 ? 1e-9 : 1e-3);
    }

    TEST("frames: a polygon is a disc of its area in .xb and its position and angle in .str; parts and chains are "
         "drawn") {
        static const char xb[] = "build/tmp/p.xb", str[] = "build/tmp/p.str";
        dem_world *w;
        moldyn m = MOLDYN;
        char text[2000];
        remove(xb);
        remove(str);
        parse(&m, MOLDYN_CONTROL, cin);
        /* a square of side sqrt(pi)/2: of a factor of 2 the disc has radius 1 */
        CHECK_EQ(parse(&m, MOLDYN_PARTICLES, "polygons 1\n4\n0 0\n.886226925 0\n.886226925 .886226925\n0 .886226925\n"
                       "1\n.5 7 0 0 1.5707963267948966 0 2 1 1\n"), DEM_OK);
        CHECK_EQ(parse(&m, MOLDYN_WALLS, polygon_win), DEM_OK);
        w = world_of(&m);
        CHECK_EQ(moldyn_add(&m, w), DEM_OK);
        CHECK_EQ(moldyn_xb_append(&m, w, xb, dem_box_make(0, 0, 0, 1, 1, 0)), DEM_OK);
        CHECK_EQ(moldyn_str_append(&m, w, str, 0.01, 1, m.planes,
                                   m.wall_count + m.parts.count + m.chains.count), DEM_OK);
        load(xb, text, sizeof text);
        CHECK_STR(text, "\n0.500000 7.000000 0.000000 0.000000 1.000000 0.000000\n");
        load(str, text, sizeof text);
        CHECK_STR(text, "0.01 1 5\n");
        CHECK_NEAR(strtod(text + 9, 0), 0, 1e-6);          /* columns x and y of a quarter turn */
        CHECK_NEAR(strtod(strchr(text + 9, ' '), 0), -1, 1e-6);
        CHECK_STR(text, " 0 0 0 1 0.500000 7.000000 0.000000\n");
        CHECK_STR(text, "\n1 0 0 0 1 0 0 0 1 0.000000 0.000000 0.000000\n1 0 0 0 1 0 0 0 1 0.000000 0.000000");
        moldyn_free(&m);
        dem_world_destroy(w);
        remove(xb);
        remove(str);
    }

    TEST("malformed polygons and chains are rejected with line, value and limit, leaving earlier data; clockwise ones "
         "are read") {
        static const struct { moldyn_file file; const char *text, *says; } rows[] = {
            {MOLDYN_PARTICLES, "polygons x\n", "line 1: found 'x' where the number of polygons"},
            {MOLDYN_PARTICLES, "polygons 1 2\n3\n", "the end of the line is expected"},
            {MOLDYN_PARTICLES, "polygons 9999999\n3\n0 0\n1 0\n0 1\n0\n",
             "line 1: found 9999999 polygons announced where the file has bytes for at most 1;"},
            {MOLDYN_PARTICLES, "polygons 1\n2\n0 0\n1 0\n0\n0\n", "found '2' where the number of corners of polygon 1 "
             "is expected, 3 to 98"},
            {MOLDYN_PARTICLES, "polygons 1\n99\n0 0\n1 0\n0 1\n", "line 2: found '99' where"},
            {MOLDYN_PARTICLES, "polygons 1\n9\n0 0\n1 0\n0 1\n", "line 2: found 9 corners announced where the file "
             "has bytes for at most 3; was it cut short?"},
            {MOLDYN_PARTICLES, "polygons 1\n3\n0 0\n1 nan\n0 1\n0\n", "line 4: found 'nan' where corner 2 of the 3 of "
             "polygon 1 is expected"},
            {MOLDYN_PARTICLES, "polygons 1\n3\n0 0\n1 2e15\n0 1\n0\n", "found '2e15' where corner 2"},
            {MOLDYN_PARTICLES, "polygons 1\n3\n0 0\n1 0 0\n0 1\n0\n", "line 4: found '0' where the end of the line"},
            {MOLDYN_PARTICLES, "polygons 1\n3\n0 0\n1 \n0 1 \n0   \n0 \n", "the end of the line where corner 2"},
            {MOLDYN_PARTICLES, "polygons 1\n4\n0 0\n1 1\n1 0\n0 1\n0\n", "line 2: polygon 1 crosses or touches itself: "
             "its sides from corner 1, (0, 0) m, and from corner 3, (1, 0) m,"},
            {MOLDYN_PARTICLES, "polygons 1\n4\n0 0\n1 0\n0 1\n0 0\n0\n", "corners 4 and 1 of polygon 1 are both "
             "(0, 0) m, must be apart; give each corner once, the first not again"},
            {MOLDYN_PARTICLES, "polygons 1\n3\n0 0\n1 1\n2 2\n0\n", "the area of polygon 1 is 0 m2"},
            {MOLDYN_PARTICLES, "polygons 1\n3\n0 0\n1 0\n0 1\npolygons 1\n3\n0 0\n1 0\n0 1\n0\n",
             "line 6: found 'polygons' where the number of grains"},
            {MOLDYN_PARTICLES, "chains 1\n2\n0 0\n1 0\n0\n", "found 'chains' where the number of grains"},
            {MOLDYN_PARTICLES, "polygons 1\n3\n0 0\n1 0\n0 1\n1\n0 0 0 0 0 0 1 1 2\n", "line 7: found polygon 2 in the "
             "last column, must be 0 (a disc) to 1"},
            {MOLDYN_PARTICLES, "1\n0 0 0 0 0 0 1 1 1\n", "found polygon 1 in the last column, must be 0 (a disc) to 0"},
            {MOLDYN_PARTICLES, "polygons 1\n3\n0 0\n1 0\n0 1\n1\n0 0 0 0 0 0 1 1 .5\n", "found polygon 0.5"},
            {MOLDYN_PARTICLES, "polygons 1\n3\n0 0\n1 0\n0 1\n1\n0 0 0 0 0 0 1 1 -1\n", "found polygon -1"},
            {MOLDYN_PARTICLES, "polygons 1\n3\n0 0\n1 0\n0 1\n1\n0 0 0 0 0 0 -2 1 1\n", "found radius (or factor of a "
             "polygon) -2 and flag 1"},
            {MOLDYN_PARTICLES, "polygons 1\n3\n0 0\n1 0\n0 1\n1\n0 0 0 0 0 0 2 3 1\n", "and flag 3 in columns 7 and 8"},
            {MOLDYN_PARTICLES, "polygons 1\n3\n0 0\n1 0\n0 1\n1\n0 0 0 0 0 0 0 0 0 0 0 0 .1 1\n", "row 1 of 1 is "
             "expected with 9 numbers, in a plane, as polygons and chains are"},
            {MOLDYN_WALLS, "chains 1\n1\n0 0\n0 0\n", "found '1' where the number of corners of chain 1 is expected, "
             "2 to 1000"},
            {MOLDYN_WALLS, "chains y\n", "the number of chains is expected"},
            {MOLDYN_WALLS, "chains 1\n4\n0 0\n1 0\n1 1\n.5 -1\n0 0\n", "line 2: chain 1 crosses or touches itself"},
            {MOLDYN_WALLS, "chains 1\n4\n0 0\n1 0\n0 1\n0 0\n0 0\n", "or list it under polygons if it is closed"},
            {MOLDYN_WALLS, "chains 1\n2\n1 0\n1 0\n0 0\n", "corners 1 and 2 of chain 1 are both (1, 0) m"},
            {MOLDYN_WALLS, "polygons 1\n3\n0 0\n1 0\n0 1\n1 0\n0 1 0 0 0 0\n", "with 4 numbers"}};
        moldyn m = MOLDYN;
        size_t i;
        parse(&m, MOLDYN_CONTROL, cin);
        CHECK_EQ(parse(&m, MOLDYN_PARTICLES, polygon_pin), DEM_OK);
        for (i = 0; i < sizeof rows/sizeof *rows; i++) {
            CHECK_EQ(parse(&m, rows[i].file, rows[i].text), DEM_ERROR_FORMAT);
            CHECK_STR(m.error, rows[i].says);
            CHECK_STR(m.error, "moldyn_parse: text line ");
            CHECK_EQ(m.grain_count*10 + m.polygons.count, 52);
        }
        /* an open one may end where a closed one crosses; clockwise is as good */
        CHECK_EQ(parse(&m, MOLDYN_WALLS, "chains 1\n3\n0 0\n1 0\n0 1\n0 0\n"), DEM_OK);
        CHECK_EQ(parse(&m, MOLDYN_PARTICLES, "polygons 1\n3\n0 0\n0 1\n1 0\n1\n0 0 0 0 0 0 1 1 1\n"), DEM_OK);
        moldyn_free(&m);
        parse(&m, MOLDYN_WALLS, win);            /* in space */
        CHECK_EQ(parse(&m, MOLDYN_PARTICLES, polygon_pin), DEM_ERROR_FORMAT);
        CHECK_STR(m.error, "line 1: found 'polygons' where rows are expected: the scene is in space");
        CHECK_EQ(m.planar, 0);
        moldyn_free(&m);
        CHECK_EQ(parse(&m, MOLDYN_WALLS, "chains 1\n2\n0 0\n1 0\n0 0\n"), DEM_OK);
        CHECK_EQ(m.planar, 1);                   /* a chain alone says so */
        CHECK_EQ(parse(&m, MOLDYN_PARTICLES, pin), DEM_ERROR_FORMAT);
        CHECK_STR(m.error, "as the other file");
        moldyn_free(&m);
    }

    TEST("hand-filled polygons are checked before anything is added, and other bodies are not mistaken for them") {
        dem_world *w, *other;
        moldyn m = MOLDYN;
        dem_real x[4] = {0, 0, 0, 0}, kept[2];
        const double nan = strtod("nan", 0);
        int had;
        parse(&m, MOLDYN_CONTROL, cin);
        CHECK_EQ(parse(&m, MOLDYN_PARTICLES, polygon_pin), DEM_OK);
        w = world_of(&m);
#define REFUSES(says) do { m.error[0] = 0; CHECK_EQ(moldyn_add(&m, w), DEM_ERROR_ARGUMENT); \
    CHECK_STR(m.error, "moldyn_add: "); CHECK_STR(m.error, says); } while (0)
        m.kinds[1] = 3;
        REFUSES("grain 1 is of kind 3, must be 0 (a disc) to 2");
        m.kinds[1] = 2;
        memcpy(kept, m.polygons.corners, sizeof kept);
        m.polygons.corners[1] = (dem_real)nan;
        REFUSES("corner 1 of polygon 1 is (0, nan) m, must be finite");
        memcpy(m.polygons.corners, m.polygons.corners + 2, sizeof kept);
        REFUSES("corners 1 and 2 of polygon 1 are both");
        memcpy(m.polygons.corners, kept, sizeof kept);
        had = m.polygons.ends[0];
        m.polygons.ends[0] = 2;
        REFUSES("of 2 polygons number 1 has not 3 to 98 corners");
        m.polygons.ends[0] = had;
        m.grains[14*2 + 12] = sizeof(dem_real) == 8 ? DEM_R(1e-75) : DEM_R(1e-10);
        REFUSES("grain 2 has a polygon's factor of 1e-");
        m.grains[14*2 + 12] = 2;
        m.planar = 0;
        dem_world_destroy(w);
        w = world_of(&m);
        REFUSES("there are 2 polygons and planar is 0");
        m.planar = 1;
        dem_world_destroy(w);
        w = world_of(&m);
        CHECK_EQ(dem_bodies_get(w).count, 0);
        CHECK_EQ(moldyn_add(&m, w), DEM_OK);
#undef REFUSES
        other = world_of(&m);                    /* the same ids, other shapes */
        {
            const dem_real square[8] = {0, 0, 1, 0, 1, 1, 0, 1};
            const dem_material_desc stuff = scene_stuff(1e6, 1, 0, 0);
            const dem_material steel = dem_material_add(other, &stuff);
            const dem_shape shape = dem_shape_polygon_add(other, 4, square);
            CHECK_EQ(shape.id, m.shapes[0].id);
            CHECK(dem_body_add(other, steel, shape, at(0, 0, 0), dem_quat_make(1, 0, 0, 0)).slot);
        }
        CHECK_EQ(moldyn_take(&m, other), DEM_ERROR_ARGUMENT);
        CHECK_STR(m.error, "moldyn_take: 1 bodies are not spheres, nor polygons that moldyn_add has added");
        CHECK_EQ(m.grain_count, 5);
        /* one more of a kind of m's, that m has not added: it is taken, with the factor it was given */
        x[3] = DEM_R(0.75);
        CHECK_EQ(dem_bodies_add(w, m.grain_material, m.shapes[0], 1, x, 0, 0, 0, x + 3), DEM_OK);
        CHECK_EQ(moldyn_take(&m, w), DEM_OK);
        CHECK_EQ(m.grain_count, 6);
        CHECK_EQ(m.kinds[5], 1);
        CHECK_REL((double)m.grains[14*5 + 12], 0.75, sizeof(dem_real) == 8 ? 1e-14 : 1e-6);
        CHECK_EQ(parse(&m, MOLDYN_PARTICLES, polygon_pin), DEM_OK);
        CHECK_EQ(moldyn_take(&m, w), DEM_ERROR_ARGUMENT);   /* these have not been added yet */
        CHECK_STR(m.error, "6 bodies are not spheres");
        moldyn_free(&m);
        dem_world_destroy(w);
        dem_world_destroy(other);
    }

    return test_end();
}
