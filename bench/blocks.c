/* blocks.c - beds of blocks at rest in a box, beside YADE and LIGGGHTS: bench/peers.sh. MIT licence.

   build/blocks --settle cubes|clumps      makes a start state anew (minutes), as build/out/blocks/NAME_1000.txt
   build/blocks --codes FOLDER             writes the start states for the other codes
   build/blocks --scene cubes|clumps       what a step and body costs here
   build/blocks --scene clumps --raw       bare numbers, for bench/peers.sh

   cubes     1000 cubes of 5 mm, convex polyhedra, in a box of 50 x 50 mm, open above
   clumps    the same of 8 spheres that touch, of a quarter of the cube's edge, 1.25 mm

   Linear springs of 10 kN/m (of a cube: where a whole face lies on another), friction .5, 2500 kg/m3. Start states are
   files of integers in bench/data: place and orientation of each block; contacts begin there without memory. Times are
   of the processor, on one thread: others may run beside. */
#define DEM_IMPLEMENTATION
#include "dem.h"
#include "examples/study.h"
#include "bench/measure.h"

#define BLOCKS_SIDE 0.05        /* m, of the box                                                */
#define BLOCKS_EDGE 5e-3        /* m, of a cube                                                 */
#define BLOCKS_STIFFNESS 1e4    /* N/m                                                          */
#define BLOCKS_RATIO (2/7.0)    /* of the tangential one to it                                  */
#define BLOCKS_DENSITY 2500.0   /* kg/m3                                                        */
#define BLOCKS_DT 5e-6          /* s                                                            */
enum { BLOCKS = 1000, TURNS = 5 };

static const char *scene_name = "all", *data_folder = "bench/data", *out = "build/out/blocks", *settle = "", *codes = "",
    *sharing = "one";
static int steps_asked = 300, warm_asked = 500, repeat_asked = TURNS, threads_asked = 1, raw, any;
static double dt_asked = BLOCKS_DT, skin_asked;

static dem_shape block_shape(dem_world *w, int clumps) {
    const double at = clumps ? BLOCKS_EDGE/4 : BLOCKS_EDGE/2;
    dem_cluster_desc c = DEM_CLUSTER_DESC;
    dem_real x[24];
    int i;
    for (i = 0; i < 24; i++) x[i] = (dem_real)(i/3 >> i%3 & 1 ? at : -at);
    if (!clumps) return dem_shape_polyhedron_add(w, 8, x);
    c.count = 8;
    c.positions = x;
    c.radius = (dem_real)at;
    c.mass = DEM_CLUSTER_SUM;           /* they touch: as their union                           */
    return dem_shape_cluster_add(w, &c);
}
/* Box, with its material. */
static dem_world *box_make(double dt, double friction, double restitution, dem_material *stuff) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc m = DEM_MATERIAL_DESC;
    dem_world *w;
    int k;
    desc.normal_law = DEM_NORMAL_LINEAR;
    desc.gravity.z = (dem_real)-9.81;
    desc.dt = (dem_real)dt;
    desc.skin = (dem_real)skin_asked;
    desc.allow_large_dt = any;
    desc.threads = threads_asked;
    desc.cluster_contacts = strcmp(sharing, "none") ? DEM_CLUSTER_CONTACTS_MERGED : DEM_CLUSTER_CONTACTS_SEPARATE;
    w = dem_world_create(&desc);
    m.density = (dem_real)BLOCKS_DENSITY;
    m.stiffness = (dem_real)BLOCKS_STIFFNESS;
    m.stiffness_ratio = (dem_real)BLOCKS_RATIO;
    m.restitution = (dem_real)restitution;
    m.friction = (dem_real)friction;
    *stuff = dem_material_add(w, &m);
    dem_wall_plane_add(w, *stuff, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
    for (k = 0; k < 4; k++) {
        const dem_real s = (dem_real)(k & 1 ? BLOCKS_SIDE : 0), n = (dem_real)(k & 1 ? -1 : 1);
        dem_wall_plane_add(w, *stuff, k < 2 ? dem_vec3_make(s, 0, 0) : dem_vec3_make(0, s, 0),
                      k < 2 ? dem_vec3_make(n, 0, 0) : dem_vec3_make(0, n, 0));
    }
    return w;
}

/* ---- start states ---- */

static const char *state_file(const char *name) {
    static char text[128];
    snprintf(text, sizeof text, "%s_%d.txt", name, BLOCKS);
    return text;
}
static void state_write(const char *name, const dem_world *w) {
    FILE *file = study_open(state_file(name));
    int i;
    if (!file) return;
    fprintf(file, "%s %d 7 columns: x y z in nm, orientation w x y z in 1e-9\n", name, BLOCKS);
    for (i = 0; i < BLOCKS; i++) {
        dem_body_state s;
        dem_body_get(w, dem_body_id_get(w, i), &s);
        fprintf(file, "%.0f %.0f %.0f %.0f %.0f %.0f %.0f\n", 1e9*(double)s.position.x, 1e9*(double)s.position.y,
                1e9*(double)s.position.z, 1e9*(double)s.orientation.w, 1e9*(double)s.orientation.x,
                1e9*(double)s.orientation.y, 1e9*(double)s.orientation.z);
    }
    study_close(file, state_file(name));
}
static void settle_scene(const char *name) {
    const int clumps = !strcmp(name, "clumps");
    const dem_real side = (dem_real)BLOCKS_SIDE;
    dem_material stuff;
    dem_world *w = box_make(dt_asked, 0.5, 0.3, &stuff);
    const dem_shape shape = block_shape(w, clumps);
    const int n = dem_bodies_fill(w, stuff, shape,
                                  dem_region_make(dem_box_make(0, 0, 0, side, side, (dem_real)0.6)), BLOCKS, 3);
    dem_totals t;
    int i;
    if (n != BLOCKS) { study_fail("%d of %d blocks found room: %s", n, BLOCKS, dem_world_error_get(w)); return; }
    for (i = 1; i <= 12; i++) {
        if (dem_world_run(w, 0.05, 0, 0) != DEM_OK) { study_fail("%s", dem_world_error_get(w)); return; }
        study_progress("blocks come to rest", i/12.0, BLOCKS*(double)dem_counters_get(w).steps);
    }
    state_write(name, w);
    t = dem_totals_get(w);
    study_result("dt", (double)dem_counters_get(w).dt, "s");
    study_result("kinetic", t.kinetic + t.rotational, "J");
    study_result("height", t.centre[2], "m");
    study_result("contacts", dem_counters_get(w).contacts, "");
    dem_world_destroy(w);
}
/* x: place and orientation, 7 a block. */
static int state_read(const char *name, dem_real *place, dem_real *turn) {
    char path[512], line[256];
    double v[7];
    int i, k;
    FILE *file;
    snprintf(path, sizeof path, "%s/%s", data_folder, state_file(name));
    file = fopen(path, "r");
    if (!file || !fgets(line, sizeof line, file)) { study_fail("cannot read %s: %s", path, strerror(errno)); return 0; }
    for (i = 0; i < BLOCKS; i++) {
        for (k = 0; k < 7; k++) if (fscanf(file, "%lf", v + k) != 1) { study_fail("%s ends early", path); return 0; }
        for (k = 0; k < 3; k++) place[3*i + k] = (dem_real)(1e-9*v[k]);
        for (k = 0; k < 4; k++) turn[4*i + k] = (dem_real)(1e-9*v[3 + k]);
    }
    fclose(file);
    return 1;
}
/* For YADE the numbers as they are, w x y z last; for LIGGGHTS the places of the spheres of each clump, which is put
   into the box as a kind of its own. */
static void write_for_codes(const char *folder) {
    static dem_real x[3*BLOCKS], q[4*BLOCKS];
    static const char *const names[] = {"cubes", "clumps"};
    char path[512];
    FILE *file;
    int i, k, s;
    study_make_folder(folder);
    for (s = 0; s < 2; s++) {
        if (!state_read(names[s], x, q)) return;
        snprintf(path, sizeof path, "%s/%s.txt", folder, names[s]);
        file = fopen(path, "w");
        if (!file) { study_fail("cannot write %s: %s", path, strerror(errno)); return; }
        for (i = 0; i < BLOCKS; i++)
            for (k = 0; k < 7; k++)
                fprintf(file, "%.10g%c", (double)(k < 3 ? x[3*i + k] : q[4*i + k - 3]), k < 6 ? ' ' : '\n');
        fclose(file);
    }
    snprintf(path, sizeof path, "%s/clumps.put", folder);
    file = fopen(path, "w");
    if (!file) { study_fail("cannot write %s: %s", path, strerror(errno)); return; }
    for (i = 0; i < BLOCKS; i++) {
        const dem_quat turn = demi_quat_again(dem_quat_make(q[4*i], q[4*i + 1], q[4*i + 2], q[4*i + 3]));
        const double r = BLOCKS_EDGE/4, m = 8*4/3.0*DEMI_PI*r*r*r*BLOCKS_DENSITY, moment = 2.4*m*r*r;
        fprintf(file, "region here block");
        for (k = 0; k < 3; k++) fprintf(file, " %.12g %.12g", (double)x[3*i + k] - 1e-12, (double)x[3*i + k] + 1e-12);
        fprintf(file, " units box volume_limit 1e-40\nfix kind all particletemplate/multisphere 15485863 atom_type 1 "
                "density constant %g nspheres 8 ntry 1000 spheres", BLOCKS_DENSITY);
        for (k = 0; k < 8; k++) {
            const dem_vec3 at = dem_quat_rotate(turn, dem_vec3_make((dem_real)(k & 1 ? r : -r), (dem_real)(k & 2 ? r : -r),
                                                                    (dem_real)(k & 4 ? r : -r)));
            fprintf(file, " %.12g %.12g %.12g %.12g", (double)at.x, (double)at.y, (double)at.z, r);
        }
        fprintf(file, " type 1 mass %.12g inertia_tensor %.12g 0 0 %.12g 0 %.12g use_density\n", m, moment, moment, moment);
        fprintf(file, "fix kinds all particledistribution/discrete 15485867 1 kind 1\n"
                "fix put all insert/pack seed 32452843 distributiontemplate kinds verbose no insert_every once overlapcheck no "
                "orientation template region here particles_in_region 1\n"
                "run 1\nunfix put\nunfix kinds\nunfix kind\nregion here delete\n");
    }
    fclose(file);
}

/* ---- measuring ---- */

static void measure(const char *name) {
    static dem_real x[3*BLOCKS], q[4*BLOCKS];
    const int clumps = !strcmp(name, "clumps");
    double times[BENCH_MOST_LOOPS];
    char what[64];
    dem_material stuff;
    dem_world *w;
    dem_counters c;
    dem_totals t;
    double high;
    int k;
    if (!state_read(name, x, q)) return;
    w = box_make(dt_asked, 0.5, 0.3, &stuff);
    if (dem_bodies_add(w, stuff, block_shape(w, clumps), BLOCKS, x, q, 0, 0, 0) != DEM_OK ||
        (high = dem_totals_get(w).centre[2], dem_world_step(w, warm_asked)) != DEM_OK) {
        study_fail("%s", dem_world_error_get(w));
        return;
    }
    for (k = 0; k < repeat_asked; k++) {
        const clock_t begun = clock();
        if (dem_world_step(w, steps_asked) != DEM_OK) { study_fail("%s", dem_world_error_get(w)); return; }
        times[k] = (double)(clock() - begun)/CLOCKS_PER_SEC;
        c = dem_counters_get(w);
        t = dem_totals_get(w);
        if (raw)                        /* s, contacts a block, J, m that the middle sank, byte a block */
            printf("raw %.6f %.5f %.6g %.6g %.0f\n", times[k], c.contacts/(double)BLOCKS,
                   t.kinetic + t.rotational, high - t.centre[2], (double)c.memory/BLOCKS);
    }
    if (!raw) {
        snprintf(what, sizeof what, "%s.step", name);
        bench_result_short(what, 1e9*bench_median(times, repeat_asked)/steps_asked/BLOCKS, "ns");
        snprintf(what, sizeof what, "%s.contacts", name);
        bench_result_short(what, c.contacts/(double)BLOCKS, "");
        snprintf(what, sizeof what, "%s.kinetic", name);
        bench_result_short(what, t.kinetic + t.rotational, "J");
        snprintf(what, sizeof what, "%s.sank", name);
        bench_result_short(what, 1e6*(high - t.centre[2]), "um");
        snprintf(what, sizeof what, "%s.candidates", name);
        bench_result_short(what, c.candidates/(double)BLOCKS, "");
        snprintf(what, sizeof what, "%s.dt", name);
        bench_result_short(what, 1e6*(double)c.dt, "us");
        snprintf(what, sizeof what, "%s.rebuilds", name);
        bench_result_short(what, (double)c.rebuilds, "");
    }
    dem_world_destroy(w);
}

int main(int argc, char **argv) {
    static const study_option table[] = {
        {"scene", STUDY_CHOICE, &scene_name, 0, 0, "all|cubes|clumps", "what to measure"},
        {"steps", STUDY_INT, &steps_asked, 1, 1e8, "", "steps of one timed loop"},
        {"warm", STUDY_INT, &warm_asked, 0, 1e8, "", "steps before the first"},
        {"repeat", STUDY_INT, &repeat_asked, 1, BENCH_MOST_LOOPS, "", "timed loops"},
        {"dt", STUDY_REAL, &dt_asked, 0, 1, "s", "time step, 0: chosen"},
        {"any_dt", STUDY_FLAG, &any, 0, 0, "", "also steps that dem.h would refuse"},
        {"skin", STUDY_REAL, &skin_asked, 0, 1, "m", "margin of the list, 0: chosen"},
        {"sharing", STUDY_CHOICE, &sharing, 0, 0, "one|none", "of contacts of a clump that push the same way"},
        {"threads", STUDY_INT, &threads_asked, 1, 64, "", "threads"},
        {"data", STUDY_TEXT, &data_folder, 0, 0, "", "folder of start states"},
        {"out", STUDY_TEXT, &out, 0, 0, "", "folder of results"},
        {"settle", STUDY_CHOICE, &settle, 0, 0, "cubes|clumps", "make a start state anew"},
        {"codes", STUDY_TEXT, &codes, 0, 0, "", "write the scenes for other codes into this folder"},
        {"raw", STUDY_FLAG, &raw, 0, 0, "", "bare numbers, for bench/peers.sh"},
    };
    study_options(argc, argv, "Beds of blocks at rest.", table, (int)(sizeof table/sizeof *table));
    if (*codes) { write_for_codes(codes); return study.failures != 0; }
    if (!raw) {
        study_begin(out);
        bench_machine();
    }
    if (*settle) { settle_scene(settle); return study_end(); }
    if (strcmp(scene_name, "clumps")) measure("cubes");
    if (strcmp(scene_name, "cubes")) measure("clumps");
    return raw ? study.failures != 0 : study_end();
}
