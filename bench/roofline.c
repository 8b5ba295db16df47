/* roofline.c - where a step stands between what the machine can compute and what it can fetch. MIT licence.

   make bench-roofline               or build/roofline: half a minute, one thread
   build/roofline --scene bed        one scene

   Measures, in the same run: bandwidth (triad a = b + s c, 24 bytes an element) with arrays that fit the first,
   second and third cache and none; the peak of fused multiply-adds; exact 1/sqrt. Then runs bed, drum and gas
   step by step with a clock around each phase:
     respond   candidates filtered, law of those that touch, pushes added to both bodies (w->kernel)
     rest      forces cleared, pushes across domains fetched, walls, sums (demi_forces without the kernel)
     move      half kicks, drift, largest speed (demi_step_move)
     search    bodies sorted, a new list, contact memory carried over (demi_rebuild), spread over its steps
   and divides by the flops and bytes counted in the table below. A bench may look inside dem.h: this one does,
   at the names above and at what demi_step_once asks before it rebuilds.

   Bytes are those that have to come from and go to where the world lies, once a step: a body's row is counted
   once for all its contacts. A multiplication, an addition, a comparison, a division and a root count as one. */
#define DEM_IMPLEMENTATION
#include "dem.h"
#include "examples/study.h"
#include "bench/measure.h"
#include "bench/scenes.h"

/* ---- what a phase does, counted by hand; R: bytes of a real ---- */

#define R ((double)sizeof(dem_real))
typedef struct work { double flops, bytes; } work;
typedef struct counted { work candidate, contact, bead, wall; } counted; /* each, in one step */

/* respond, Hertz with a spring (bed, drum). The filter: 3 differences, 6 for d^2 - 4 r^2; two indices of 4 bytes.
   A contact: touch 18 (root and division among them), velocities 38, those of the step 80, Hertz 10, memory
   turned 51, spring and Coulomb 33, pushes 21, added to both 13; memory of 4 reals and a stamp read and
   written. A bead: place, velocity, spin, half velocity, half spin read (4 reals each), force and torque read
   and written. */
static const counted respond_friction = {{9, 8}, {264, 8*sizeof(dem_real) + 8}, {0, 36*sizeof(dem_real)}, {0, 0}};
/* the same without friction, linear (gas): touch 18, velocity 8, law 4, push 3, added 7. A bead: its place. Velocity
   and force only of the few that touch: 4 reals read, 4 read and written, of both */
static const counted respond_smooth = {{9, 8}, {40, 24*sizeof(dem_real)}, {0, 4*sizeof(dem_real)}, {0, 0}};
/* rest: force and torque set to zero; a wall contact: about 300 flops, its record read and written */
static const counted rest_friction = {{0, 0}, {0, 0}, {0, 8*sizeof(dem_real)}, {300, 2*sizeof(demi_wall_contact)}};
static const counted rest_smooth = {{0, 0}, {0, 0}, {0, 4*sizeof(dem_real)}, {0, 0}};
/* move: 6 a component to kick, of velocity and spin; 6 to drift; 7 for the largest speed. Place and half velocity
   read and written, velocity written, force read, inverse mass; half spin, spin, torque, inverse inertia */
static const counted move_friction = {{0, 0}, {0, 0}, {49, (4*11 - 2)*sizeof(dem_real)}, {0, 0}};
static const counted move_smooth = {{0, 0}, {0, 0}, {31, (4*6 + 1)*sizeof(dem_real)}, {0, 0}};
/* search, of one rebuild: 13 rows of 4 reals permuted (read, written, and again through scratch), indices; 9
   flops for each pair asked (below); a candidate's indices, stamp and memory written, a contact's memory carried
   there and back */
static const counted search_friction = {{0, 12 + 4*sizeof(dem_real)}, {0, 16*sizeof(dem_real) + 16},
                                        {0, 13*4*4*sizeof(dem_real) + 24}, {0, 0}};
static const counted search_smooth = {{0, 12}, {0, 0}, {0, 13*4*4*sizeof(dem_real) + 24}, {0, 0}};
#define IMAGE_FLOPS 6 /* nearest image across three periodic axes, of a candidate and of a contact */

enum { RESPOND, REST, MOVE, SEARCH, WHOLE, PHASES };
static const char *const phase_names[PHASES] = {"respond", "rest", "move", "search", "whole"};

/* ---- limits of the machine, one core ---- */

enum { L1, L2, L3, MEMORY, LEVELS };
static const char *const level_names[LEVELS] = {"L1", "L2", "L3", "memory"};
static double bandwidth[LEVELS], peak, roots;      /* byte/s, flop/s, 1/s */
static double level_kib[LEVELS] = {24, 384, 9216, 786432}; /* three arrays together */

/* not inlined: gcc forgets that the arrays are apart where it inlines, and stays scalar */
DEMI_NOINLINE void triad(dem_real *DEMI_RESTRICT a, const dem_real *DEMI_RESTRICT b, const dem_real *DEMI_RESTRICT c,
                  dem_real s, size_t n) {
    size_t i;
    for (i = 0; i < n; i++) a[i] = b[i] + s*c[i];
}
static double measure_triad(double kib) { /* byte/s, best of several: the limit is what is asked          */
    const size_t n = (size_t)(1024*kib/3/sizeof(dem_real)), loops = (size_t)(4e8/(3*R*(double)n)) + 1;
    dem_real *a = (dem_real *)study_alloc(n, sizeof *a), *b = (dem_real *)study_alloc(n, sizeof *b);
    dem_real *c = (dem_real *)study_alloc(n, sizeof *c);
    double best = 0;
    size_t k;
    int turn;
    for (k = 0; k < n; k++) a[k] = b[k] = c[k] = (dem_real)(k%7);
    for (turn = 0; turn < 7; turn++) {
        const double begun = study_clock();
        for (k = 0; k < loops; k++) triad(a, b, c, (dem_real)(0.5 + 1e-9*(double)k), n);
        best = fmax(best, 3*R*(double)(n*loops)/(study_clock() - begun));
    }
    if (a[n/2] != a[n/2]) study_fail("triad came out wrong");
    free(a); free(b); free(c);
    return best;
}
/* Sixteen dependent multiply-adds on each of 1024 numbers: enough chains for any core. */
#if defined(FP_FAST_FMA) || defined(__FMA__) || defined(__ARM_FEATURE_FMA)
#define MULTIPLY_ADD(x, m, s) ((dem_real)(sizeof(dem_real) == 4 ? (double)fmaf((float)(x), (float)(m), (float)(s)) \
                                                                : fma((double)(x), (double)(m), (double)(s))))
#else
#define MULTIPLY_ADD(x, m, s) ((x)*(m) + (s))
#endif
DEMI_NOINLINE void multiply_adds(dem_real *DEMI_RESTRICT x, dem_real m, dem_real s, int n) {
    int i;
    for (i = 0; i < n; i++) {
        dem_real v = x[i];
        v = MULTIPLY_ADD(v, m, s); v = MULTIPLY_ADD(v, m, s); v = MULTIPLY_ADD(v, m, s); v = MULTIPLY_ADD(v, m, s);
        v = MULTIPLY_ADD(v, m, s); v = MULTIPLY_ADD(v, m, s); v = MULTIPLY_ADD(v, m, s); v = MULTIPLY_ADD(v, m, s);
        v = MULTIPLY_ADD(v, m, s); v = MULTIPLY_ADD(v, m, s); v = MULTIPLY_ADD(v, m, s); v = MULTIPLY_ADD(v, m, s);
        v = MULTIPLY_ADD(v, m, s); v = MULTIPLY_ADD(v, m, s); v = MULTIPLY_ADD(v, m, s); v = MULTIPLY_ADD(v, m, s);
        x[i] = v;
    }
}
DEMI_NOINLINE void inverse_roots(dem_real *DEMI_RESTRICT y, const dem_real *DEMI_RESTRICT x, int n) {
    int i;
    for (i = 0; i < n; i++) y[i] = 1/DEMI_SQRT(x[i]);
}
static void measure_limits(void) {
    static dem_real x[1024], y[1024];
    char name[32];
    double begun;
    int k, turn;
    for (k = 0; k < LEVELS; k++) {
        bandwidth[k] = measure_triad(level_kib[k]);
        snprintf(name, sizeof name, "triad.%s", level_names[k]);
        bench_result_short(name, 1e-9*bandwidth[k], "GB/s");
    }
    for (k = 0; k < 1024; k++) x[k] = (dem_real)(1 + 0.001*k);
    for (turn = 0; turn < 7; turn++) {
        begun = study_clock();
        for (k = 0; k < 20000; k++) multiply_adds(x, DEM_R(0.999), DEM_R(0.001), 1024);
        peak = fmax(peak, 2*16*1024.0*20000/(study_clock() - begun));
        begun = study_clock();
        for (k = 0; k < 20000; k++) { inverse_roots(y, x, 1024); x[k%1024] = y[k%1024] + 1; }
        roots = fmax(roots, 1024.0*20000/(study_clock() - begun));
    }
    if (x[3] != x[3]) study_fail("multiply-adds came out wrong");
    bench_result_short("fma_peak", 1e-9*peak, "GFLOP/s");
    bench_result_short("inverse_root", 1e-9*roots, "G/s (1/sqrt, exact)");
}

/* ---- steps with a clock ---- */

static void (*kernel)(dem_world *w, int domain);
static double kernel_time;
static void kernel_timed(dem_world *w, int domain) {
    const double begun = study_clock();
    kernel(w, domain);
    kernel_time += study_clock() - begun;
}
static void kernel_choose(dem_world *w) {
    demi_kernel_choose(w);
    kernel = w->kernel;
    w->kernel = kernel_timed;
}
/* demi_step_once with clocks; time[] grows. 0: the run broke. */
static int step_timed(dem_world *w, double time[PHASES]) {
    const double begun = study_clock();
    double moved, found, done;
    if (demi_step_move(w) != DEM_OK) return 0;
    moved = found = study_clock();
    if (!w->list_valid || w->skin <= 0 || 2*w->reach > w->skin || w->reach + w->wall_reach > w->skin) {
        if (demi_rebuild(w) != DEM_OK) return 0;
        kernel_choose(w);
        found = study_clock();
    }
    kernel_time = 0;
    demi_forces(w);
    w->moved = 0;
    done = study_clock();
    time[MOVE] += moved - begun;
    time[SEARCH] += found - moved;
    time[RESPOND] += kernel_time;
    time[REST] += done - found - kernel_time;
    time[WHOLE] += done - begun;
    return 1;
}

/* ---- a scene ---- */

static FILE *page;
static int turns_asked = 5, steps_asked;
static double second_kib = 1024, third_kib = 32768;

/* Flops and bytes of a phase per bead and step. */
static work count_work(int phase, const bench_scene *s, const dem_counters *c, double rebuilds) {
    const int smooth = bench_is(s, "gas"), periodic = s->side[0] > 0;
    const counted *t = phase == RESPOND ? (smooth ? &respond_smooth : &respond_friction)
                     : phase == REST ? (smooth ? &rest_smooth : &rest_friction)
                     : phase == MOVE ? (smooth ? &move_smooth : &move_friction)
                                     : (smooth ? &search_smooth : &search_friction);
    const double n = s->count, image = phase == RESPOND && periodic ? IMAGE_FLOPS : 0;
    const double candidates = c->candidates/n, contacts = c->contacts/n, walls = c->wall_contacts/n;
    work sum;
    sum.flops = candidates*(t->candidate.flops + image) + contacts*(t->contact.flops + image) + t->bead.flops + walls*t->wall.flops;
    sum.bytes = candidates*t->candidate.bytes + contacts*t->contact.bytes + t->bead.bytes + walls*t->wall.bytes;
    if (phase == SEARCH) { /* pairs asked: 13 1/2 cells of a diameter and a skin, at the scene's solid fraction */
        const double edge = 2 + (double)c->skin/s->radius, solid = smooth ? 0.058 : 0.6;
        sum.flops += 9*13.5*solid*edge*edge*edge/(4*3.14159265/3);
        sum.flops *= rebuilds;
        sum.bytes *= rebuilds;
    }
    return sum;
}
static void roofs_draw(const bench_scene *s, const double x[PHASES], const double y[PHASES]) {
    static double rx[LEVELS][3], ry[LEVELS][3];
    study_figure f;
    char title[128], name[64];
    int k;
    memset(&f, 0, sizeof f);
    snprintf(title, sizeof title, "Phases of a step under the roofs of one core: %s", s->name);
    f.title = title;
    f.x_label = "flop per byte moved";
    f.y_label = "GFLOP/s";
    f.log_x = f.log_y = 1;
    f.x0 = -2; f.x1 = 2;
    f.y0 = -1; f.y1 = ceil(log10(1e-9*peak) + 0.1);
    for (k = 0; k < LEVELS; k++) {
        rx[k][0] = 0.01; rx[k][1] = peak/bandwidth[k]; rx[k][2] = 100;
        ry[k][0] = 1e-11*bandwidth[k]; ry[k][1] = ry[k][2] = 1e-9*peak;
        study_curve(&f, k ? 0 : "roofs: L1, L2, L3, memory", STUDY_FAINT, 3, rx[k], ry[k]);
    }
    for (k = 0; k < PHASES; k++) study_curve(&f, phase_names[k], STUDY_DOTS, 1, &x[k], &y[k]);
    snprintf(name, sizeof name, "roofline_%s.svg", s->name);
    study_figure_write(&f, name);
}
static void tell_scene(const bench_scene *s, const dem_counters *c, double times[PHASES][BENCH_MOST_LOOPS], int turns,
                       double rebuilds) {
    const double kib = (double)c->memory/1024;
    const int level = kib < second_kib ? L2 : kib < third_kib ? L3 : MEMORY;
    double x[PHASES], y[PHASES];
    work sum = {0, 0};
    int p;
    char name[64], unit[64];
    snprintf(study.prefix, sizeof study.prefix, "%s.", s->name);
    bench_result_short("memory", kib/1024, "MiB");
    bench_result_short("steps_per_rebuild", 1/rebuilds, "");
    bench_result_short("pairs_per_bead", (double)c->candidates/s->count, "");
    bench_result_short("contacts_per_bead", 2.0*c->contacts/s->count, "");
    for (p = 0; p < PHASES; p++) {
        const double ns = 1e9*bench_median(times[p], turns);
        work here = p == WHOLE ? sum : count_work(p, s, c, rebuilds);
        double roof;
        if (p != WHOLE) { sum.flops += here.flops; sum.bytes += here.bytes; }
        roof = 1e9*fmax(here.flops/peak, here.bytes/bandwidth[level]); /* ns */
        x[p] = here.flops/here.bytes;
        y[p] = here.flops/ns;
        snprintf(name, sizeof name, "%s.time", phase_names[p]);
        snprintf(unit, sizeof unit, "ns a bead and step (+- %.0f %%)", bench_spread(times[p], turns));
        bench_result_short(name, ns, unit);
        snprintf(name, sizeof name, "%s.flops", phase_names[p]);
        bench_result_short(name, here.flops, "a bead and step");
        snprintf(name, sizeof name, "%s.bytes", phase_names[p]);
        bench_result_short(name, here.bytes, "a bead and step");
        snprintf(name, sizeof name, "%s.rate", phase_names[p]);
        bench_result_short(name, y[p], "GFLOP/s");
        snprintf(name, sizeof name, "%s.bandwidth", phase_names[p]);
        bench_result_short(name, here.bytes/ns, "GB/s");
        snprintf(name, sizeof name, "%s.of_roof", phase_names[p]);
        snprintf(unit, sizeof unit, "%% (%s, %s)", level_names[level],
                 here.flops/peak > here.bytes/bandwidth[level] ? "arithmetic" : "bandwidth");
        bench_result_short(name, 100*roof/ns, unit);
        if (page) fprintf(page, "| %s | %s | %.1f | %.0f | %.0f | %.2f | %.2f | %.1f | %.0f %%, %s %s |\n", s->name, phase_names[p], ns,
                          here.flops, here.bytes, x[p], y[p], here.bytes/ns, 100*roof/ns, level_names[level],
                          here.flops/peak > here.bytes/bandwidth[level] ? "arithmetic" : "bandwidth");
    }
    study.prefix[0] = 0;
    roofs_draw(s, x, y);
}
/* When turns hold few rebuilds or none, a median says nothing: the mean of all, or one forced rebuild spread over
   all steps taken (which is then an upper bound). Answers rebuilds per step. */
static double search_rare(dem_world *w, double *times, int turns, double rebuilds, int steps) {
    double sum = 0, begun;
    int k;
    for (k = 0; k < turns; k++) sum += times[k];
    if (!(rebuilds > 0)) {
        begun = study_clock();
        if (demi_rebuild(w) != DEM_OK) study_fail("%s", dem_world_error(w));
        sum = (study_clock() - begun)/steps/w->count;
        rebuilds = 1.0/(steps*turns);
    }
    for (k = 0; k < turns; k++) times[k] = sum/turns;
    return rebuilds;
}
static void scene_place(const char *folder, const char *name) {
    static double times[PHASES][BENCH_MOST_LOOPS];
    bench_choice choice = BENCH_CHOICE;
    bench_scene s = bench_scene_read(folder, name);
    dem_world *w = bench_world(&s, &choice);
    const int steps = steps_asked ? steps_asked : bench_is(&s, "gas") ? 600 : 150;
    double time[PHASES], rebuilds;
    int turn, p, k, ok = w && dem_world_step(w, 100) == DEM_OK;
    if (ok) {
        kernel_choose(w);
        rebuilds = (double)w->rebuilds;
        for (turn = 0; turn < turns_asked && ok; turn++) {
            for (p = 0; p < PHASES; p++) time[p] = 0;
            for (k = 0; k < steps && ok; k++) ok = step_timed(w, time);
            for (p = 0; p < PHASES; p++) times[p][turn] = time[p]/steps/s.count;
        }
        if (ok) {
            const dem_counters c = dem_counters_get(w);
            rebuilds = ((double)w->rebuilds - rebuilds)/(steps*turns_asked);
            if (rebuilds*steps < 3) rebuilds = search_rare(w, times[SEARCH], turns_asked, rebuilds, steps);
            tell_scene(&s, &c, times, turns_asked, rebuilds);
        }
    }
    if (!ok) study_fail("%s: %s", name, w ? dem_world_error(w) : "no world");
    dem_world_destroy(w);
    bench_scene_free(&s);
}

int main(int argc, char **argv) {
    static const char *scene_name = "all", *folder = "bench/data", *out = "build/out/roofline";
    static const study_option table[] = {
        {"scene", STUDY_CHOICE, &scene_name, 0, 0, "all|bed|drum|gas|limits", "what to place"},
        {"steps", STUDY_INT, &steps_asked, 0, 1e8, "", "of one turn, 0: by scene"},
        {"turns", STUDY_INT, &turns_asked, 1, BENCH_MOST_LOOPS, "", "of which medians are told"},
        {"l2", STUDY_REAL, &second_kib, 1, 1e9, "KiB", "second cache: what is larger lies in the third"},
        {"l3", STUDY_REAL, &third_kib, 1, 1e9, "KiB", "third cache, what one core gets of it"},
        {"data", STUDY_TEXT, &folder, 0, 0, "", "where the start states are"},
        {"out", STUDY_TEXT, &out, 0, 0, "", "folder of results"},
    };
    static const char *const names[3] = {"bed", "drum", "gas"};
    const double load = bench_load();
    int i;
    study_options(argc, argv, "Where a step stands between arithmetic and bandwidth.", table, (int)(sizeof table/sizeof *table));
    study_begin(out);
    bench_machine();
    measure_limits();
    page = bench_page_open();
    if (page) {
        bench_page_machine(page, load);
        fprintf(page, "One core: triad %.0f GB/s in L1, %.0f in L2, %.0f in L3, %.1f from memory; multiply-adds %.1f GFLOP/s; "
                "exact 1/sqrt %.2f G/s.\n\n| scene | phase | ns a bead and step | flops | bytes | flop/byte | GFLOP/s | GB/s | "
                "of the roof |\n|---|---|---|---|---|---|---|---|---|\n", 1e-9*bandwidth[L1], 1e-9*bandwidth[L2],
                1e-9*bandwidth[L3], 1e-9*bandwidth[MEMORY], 1e-9*peak, 1e-9*roots);
    }
    for (i = 0; i < 3; i++)
        if (!strcmp(scene_name, "all") || !strcmp(scene_name, names[i])) scene_place(folder, names[i]);
    study_close(page, "page.md");
    return study_end();
}
