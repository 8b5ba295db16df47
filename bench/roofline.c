/* roofline.c - compares each phase of a step with the arithmetic and bandwidth limits of the machine. MIT licence.

   make build/roofline && build/roofline     half a minute, one thread
   build/roofline --scene bed                one scene

   Measures, in the same run: bandwidth (triad a = b + s c, 24 bytes per element) with arrays that fit in L1, L2, L3 and
   in none of them; the peak of fused multiply-adds; exact 1/sqrt. Then runs bed, drum and gas step by step with a clock
   around each phase:
     respond   pairs of the pruned list: bodies copied into rows, contact, motion, law, forces added to both (demi_pairs)
     rest      forces fetched from other domains, walls, sums (demi_forces without them)
     move      half kicks, drift, largest changes, forces cleared (demi_step_move)
     near      a new pruned list from the candidates (demi_near_make), spread over its steps
     search    bodies sorted, new candidates, a pruned list, contact history carried over (demi_rebuild), spread likewise
   and divides by the flops and bytes of the table below, which were counted in the source. A bench may use internals of
   dem.h: this one uses the names above and the condition under which demi_step_once rebuilds.

   Bytes are those that have to be read from or written to the memory level that holds the world, once per step: a body's
   row is counted once for all its contacts. A multiplication, an addition, a comparison, a division and a root count as
   one flop each. The counts do not depend on the load of the machine: they have a table of their own (counts.md and
   roofline_counts.csv). */
#define DEM_IMPLEMENTATION
#include "dem.h"
#include "examples/study.h"
#include "bench/measure.h"
#include "bench/scenes.h"

/* ---- work of each phase, counted in the source; R: bytes of a real ---- */

#define R ((double)sizeof(dem_real))
typedef struct work { double flops, bytes; } work;
/* each, in one step (near, search: when made): a candidate, a near pair, one of those that lead out of a domain, a
   contact, a bead, a wall contact */
typedef struct counted { work candidate, near, cross, contact, bead, wall; } counted;
enum { REALS = sizeof(dem_real) };

/* respond, Hertz with a spring, alike (bed, drum). The work is that of a near pair, whether it touches or not:
     fetch    18: 3 across, 3 to the image; differences of velocity and sums of spin, now and of the step, 12
     touch    14: length 6, 1/length 2, normal 3, overlap and depth 2, does it touch 1
     motion   90: closing 5, slip 21; of the step: turn of the normal 14, arm 4, slip_step 40, twist 6
     law      95: Hertz 10, memory turned 49, spring and Coulomb 36
     answers  29: memory 3 and pushes 8 that count only where it touches; force 6, torque 12
     tally     2, scatter 12
   Indices of 4 bytes and an image of 1, three reals of memory read and written. Rows (demi_tile) stay in the first
   cache and are not counted. A bead: place, velocity, spin, half velocity, half spin read (4 reals each), force and
   torque read and written. One that leads out leaves six reals. */
static const counted respond_friction = {{0, 0}, {260, 9 + 6*REALS}, {0, 6*REALS}, {0, 0}, {0, 36*REALS}, {0, 0}};
/* the same without friction, linear (gas): fetch 9, touch 14, motion 5, law 4, answers 7, tally 2, scatter 6. No
   bead but those of near pairs, few: place and velocity read, force read and written, of both */
static const counted respond_smooth = {{0, 0}, {47, 9 + 32*REALS}, {0, 3*REALS}, {0, 0}, {0, 0}, {0, 0}};
/* rest: a push that leads out, added at its other end; a wall contact: about 300 flops; its record written, and the first
   part of that of the last step read */
static const counted rest_friction = {{0, 0}, {0, 0}, {6, 12 + 18*REALS}, {0, 0}, {0, 0},
                                      {300, offsetof(demi_persistent, more) + offsetof(demi_persistent, arm_b)}};
static const counted rest_smooth = {{0, 0}, {0, 0}, {3, 12 + 9*REALS}, {0, 0}, {0, 0}, {0, 0}};
/* move: to kick and drift 9 a component, to kick spin 5; pace 19. Place, half velocity, force read and written (force:
   cleared), velocity written, inverse mass; the same for spin and torque. A quiet bead: 6; place read and written, half
   velocity read */
static const counted move_friction = {{0, 0}, {0, 0}, {0, 0}, {0, 0}, {61, 50*REALS}, {0, 0}};
static const counted move_smooth = {{0, 0}, {0, 0}, {0, 0}, {0, 0}, {46, 29*REALS}, {0, 0}};
static const counted move_quiet = {{0, 0}, {0, 0}, {0, 0}, {0, 0}, {6, 12*REALS}, {0, 0}};
/* near, when it is made. A candidate: 6 to the image, 3 differences of velocity, 5 and 6 for their lengths, 6 to compare;
   indices, image and entry read, entry cleared. A near pair: bodies, image, candidate and entry written, memory
   copied. A bead: place and velocity */
static const counted near_friction = {{26, 17}, {0, 17 + 6*REALS}, {0, 0}, {0, 0}, {0, 8*REALS}, {0, 0}};
static const counted near_smooth = {{26, 17}, {0, 17}, {0, 0}, {0, 0}, {0, 8*REALS}, {0, 0}};
/* search, of one rebuild: 13 rows of 4 reals permuted (read, written, and again through scratch), indices; 9 flops for
   each pair asked (below); a candidate's indices and image written; a contact's memory filed and fetched; and a
   near list */
static const counted search_friction = {{26, 9 + 17}, {0, 17 + 3*REALS}, {0, 0}, {0, 9*REALS + 16},
                                        {0, (13*4*4 + 8)*REALS + 24}, {0, 0}};
static const counted search_smooth = {{26, 9 + 17}, {0, 17}, {0, 0}, {0, 0}, {0, (13*4*4 + 8)*REALS + 24}, {0, 0}};

enum { RESPOND, REST, MOVE, NEAR, SEARCH, WHOLE, PHASES };
static const char *const phase_names[PHASES] = {"respond", "rest", "move", "near", "search", "whole"};

/* ---- limits of the machine, one core ---- */

enum { L1, L2, L3, MEMORY, LEVELS };
static const char *const level_names[LEVELS] = {"L1", "L2", "L3", "memory"};
static double bandwidth[LEVELS], peak, roots;      /* byte/s, flop/s, 1/s */
static double level_kib[LEVELS] = {24, 384, 9216, 786432}; /* three arrays together */

#if defined(__GNUC__)
#define APART static __attribute__((noinline))
#else
#define APART static
#endif
/* not inlined: gcc forgets that the arrays are apart where it inlines, and stays scalar */
APART void triad(dem_real *DEMI_RESTRICT a, const dem_real *DEMI_RESTRICT b, const dem_real *DEMI_RESTRICT c,
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
APART void multiply_adds(dem_real *DEMI_RESTRICT x, dem_real m, dem_real s, int n) {
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
APART void inverse_roots(dem_real *DEMI_RESTRICT y, const dem_real *DEMI_RESTRICT x, int n) {
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

enum { SAMPLE = 8 };    /* every how many steps the pairs are timed alone */
/* Returns the time of the loop over pairs: it runs once more, without time, and what it wrote is put back. */
static double pairs_timed(dem_world *w) {
    const size_t bodies = 4*(size_t)w->bodies.count*sizeof(dem_real);
    const size_t history = (size_t)w->domain_count*(size_t)w->memory_stride*(size_t)w->near.stride*sizeof(dem_real);
    char *kept = (char *)malloc(2*bodies + history + sizeof(demi_domain)*(size_t)w->domain_count);
    const int valid = w->stage.forces_valid;
    double begun;
    int d;
    if (!kept) return 0;
    memcpy(kept, w->bodies.force, bodies);
    memcpy(kept + bodies, w->bodies.torque, bodies);
    if (history) memcpy(kept + 2*bodies, w->near.memory, history);
    memcpy(kept + 2*bodies + history, w->domains, sizeof(demi_domain)*(size_t)w->domain_count);
    w->stage.forces_valid = 0;
    begun = study_clock();
    for (d = 0; d < w->domain_count; d++) demi_pairs(w, d);
    begun = study_clock() - begun;
    w->stage.forces_valid = valid;
    memcpy(w->bodies.force, kept, bodies);
    memcpy(w->bodies.torque, kept + bodies, bodies);
    if (history) memcpy(w->near.memory, kept + 2*bodies, history);
    memcpy(w->domains, kept + 2*bodies + history, sizeof(demi_domain)*(size_t)w->domain_count);
    free(kept);
    return begun;
}
static double near_made, search_made;  /* how often, so far */
/* demi_step_once with clocks; time[] grows. 0: the run broke. */
static int step_timed(dem_world *w, double time[PHASES]) {
    const double begun = study_clock();
    double moved, found, done;
    int phase = MOVE;
    if (demi_step_move(w) != DEM_OK) return 0;
    demi_near_pass(w, w->margin.last_change);
    w->stage.moved = 1;
    moved = found = study_clock();
    if (!w->stage.list_valid || w->margin.skin <= 0 || 2*w->margin.gone > w->margin.skin || w->margin.gone + w->margin.walls_gone > w->margin.skin) {
        if (demi_rebuild(w, "dem_world_step") != DEM_OK) return 0;
        phase = SEARCH;
        search_made++;
    } else if (demi_near_due(w)) {
        demi_near_choose(w);
        if (!demi_near_make(w, 0)) return 0;
        phase = NEAR;
        near_made++;
    }
    if (phase != MOVE) found = study_clock();
    if (!demi_touch(w)) return 0;               /* counted with the rest: walls */
    demi_forces(w);
    w->stage.moved = 0;
    done = study_clock();
    time[MOVE] += moved - begun;
    time[phase] += found - moved;
    time[REST] += done - found;                 /* and the pairs, until scene_place takes them out */
    if (w->clock.steps%SAMPLE == 0) time[RESPOND] += SAMPLE*pairs_timed(w);
    time[WHOLE] += done - begun;
    return 1;
}

/* ---- a scene ---- */

static FILE *page, *counts, *data;
static int turns_asked = 5, steps_asked;
static double second_kib = 1024, third_kib = 32768;

/* Numbers per bead, averaged over samples of the scene; rebuilds and pruned lists per step. */
typedef struct tallies { double candidates, near, cross, contacts, walls, quiet, rebuilds, nears; int looks; } tallies;

static void look(const dem_world *w, tallies *t) {
    const dem_counters c = dem_counters_get(w);
    const double n = w->bodies.count;
    int d, i, k = t->looks++;
    double near = 0, cross = 0, quiet = 0;
    for (d = 0; d < w->domain_count; d++) {
        const demi_domain *domain = &w->domains[d];
        cross += domain->near_end - domain->near_cross;
        near += domain->near_own + domain->near_end - domain->near_cross;
        for (i = domain->begin; i < domain->end && demi_quiet_possible(w); i++) quiet += !demi_quiet_at(w, d, i)->restless;
    }
    t->candidates += (c.candidates/n - t->candidates)/(k + 1);
    t->contacts += (c.contacts/n - t->contacts)/(k + 1);
    t->walls += (c.wall_contacts/n - t->walls)/(k + 1);
    t->near += (near/n - t->near)/(k + 1);
    t->cross += (cross/n - t->cross)/(k + 1);
    t->quiet += (quiet/n - t->quiet)/(k + 1);
}
static void add_work(work *sum, work each, double count) { sum->flops += count*each.flops; sum->bytes += count*each.bytes; }

/* Flops and bytes of a phase per bead and step. */
static work count_work(int phase, const bench_scene *s, const tallies *t, double skin) {
    const int smooth = bench_is(s, "gas");
    const counted *c = phase == RESPOND ? (smooth ? &respond_smooth : &respond_friction)
                     : phase == REST ? (smooth ? &rest_smooth : &rest_friction)
                     : phase == MOVE ? (smooth ? &move_smooth : &move_friction)
                     : phase == NEAR ? (smooth ? &near_smooth : &near_friction)
                                     : (smooth ? &search_smooth : &search_friction);
    const double often = phase == SEARCH ? t->rebuilds : phase == NEAR ? t->nears : 1;
    const double quiet = phase == MOVE ? t->quiet : 0;
    work sum = {0, 0};
    add_work(&sum, c->candidate, t->candidates);
    add_work(&sum, c->near, t->near);
    add_work(&sum, c->cross, t->cross);
    add_work(&sum, c->contact, t->contacts);
    add_work(&sum, c->bead, 1 - quiet);
    add_work(&sum, move_quiet.bead, quiet);
    add_work(&sum, c->wall, t->walls);
    if (phase == SEARCH) { /* pairs asked: 13 1/2 cells of a diameter and a skin, at the scene's solid fraction */
        const double edge = 2 + skin/s->radius, solid = smooth ? 0.058 : 0.6;
        sum.flops += 9*13.5*solid*edge*edge*edge/(4*3.14159265/3);
    }
    sum.flops *= often;
    sum.bytes *= often;
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
                       const tallies *t) {
    const double kib = (double)c->memory/1024;
    const int level = kib < second_kib ? L2 : kib < third_kib ? L3 : MEMORY;
    double x[PHASES], y[PHASES];
    work sum = {0, 0};
    int p;
    char name[64], unit[64];
    snprintf(study.prefix, sizeof study.prefix, "%s.", s->name);
    bench_result_short("memory", kib/1024, "MiB");
    bench_result_short("steps_per_rebuild", 1/t->rebuilds, "");
    if (t->nears > 0) bench_result_short("steps_per_near_list", 1/(t->nears + t->rebuilds), "");
    bench_result_short("pairs_per_bead", t->candidates, "");
    bench_result_short("near_pairs_per_bead", t->near, "");
    bench_result_short("contacts_per_bead", 2*t->contacts, "");
    if (t->quiet > 0) bench_result_short("quiet", 100*t->quiet, "% of the beads");
    for (p = 0; p < PHASES; p++) {
        const double ns = 1e9*bench_median(times[p], turns);
        work here = p == WHOLE ? sum : count_work(p, s, t, (double)c->skin);
        double roof;
        if (!(ns > 0) || !(here.bytes > 0)) { x[p] = y[p] = 1e-9; continue; } /* did not happen; off the picture */
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
        if (counts) fprintf(counts, "| %s | %s | %.0f | %.0f | %.2f |\n", s->name, phase_names[p], here.flops, here.bytes, x[p]);
        if (data) fprintf(data, "%s,%s,%.0f,%.0f,%.2f\n", s->name, phase_names[p], here.flops, here.bytes, x[p]);
        if (page) fprintf(page, "| %s | %s | %.1f | %.2f | %.1f | %.0f | %s, %s |\n", s->name, phase_names[p], ns, y[p],
                          here.bytes/ns, 100*roof/ns, here.flops/peak > here.bytes/bandwidth[level] ? "arithmetic" : "bandwidth",
                          level_names[level]);
    }
    study.prefix[0] = 0;
    roofs_draw(s, x, y);
}
/* When turns hold few of them or none, a median says nothing: the mean of all. */
static void mean_of_turns(double *times, int turns, double sum) {
    int k;
    for (k = 0; k < turns; k++) sum += times[k];
    for (k = 0; k < turns; k++) times[k] = sum/turns;
}
/* Or one forced rebuild spread over all steps taken, which is then an upper bound. Answers rebuilds per step. */
static double search_rare(dem_world *w, double *times, int turns, double rebuilds, int steps) {
    double spent = 0, begun;
    if (!(rebuilds > 0)) {
        begun = study_clock();
        if (demi_rebuild(w, "dem_world_step") != DEM_OK) study_fail("%s", dem_world_error_get(w));
        spent = (study_clock() - begun)/steps/w->bodies.count;
        rebuilds = 1.0/(steps*turns);
    }
    mean_of_turns(times, turns, spent);
    return rebuilds;
}
static void scene_place(const char *folder, const char *name) {
    static double times[PHASES][BENCH_MOST_LOOPS];
    bench_choice choice = BENCH_CHOICE;
    bench_scene s = bench_scene_read(folder, name);
    dem_world *w = bench_world(&s, &choice);
    const int steps = steps_asked ? steps_asked : bench_is(&s, "gas") ? 600 : 150;
    double time[PHASES];
    tallies t;
    int turn, p, k, ok = w && dem_world_step(w, 100) == DEM_OK;
    if (ok) {
        near_made = search_made = 0;
        memset(&t, 0, sizeof t);
        for (turn = 0; turn < turns_asked && ok; turn++) {
            for (p = 0; p < PHASES; p++) time[p] = 0;
            for (k = 0; k < steps && ok; k++) {
                ok = step_timed(w, time);
                if (k%16 == 15 || steps < 16) look(w, &t);
            }
            time[REST] -= time[RESPOND];
            for (p = 0; p < PHASES; p++) times[p][turn] = time[p]/steps/s.count;
        }
        if (ok) {
            const dem_counters c = dem_counters_get(w);
            t.rebuilds = search_made/(steps*turns_asked);
            t.nears = near_made/(steps*turns_asked);
            if (t.nears*steps < 3) mean_of_turns(times[NEAR], turns_asked, 0);
            if (t.rebuilds*steps < 3) t.rebuilds = search_rare(w, times[SEARCH], turns_asked, t.rebuilds, steps);
            tell_scene(&s, &c, times, turns_asked, &t);
        }
    }
    if (!ok) study_fail("%s: %s", name, w ? dem_world_error_get(w) : "no world");
    dem_world_destroy(w);
    bench_scene_free(&s);
}

int main(int argc, char **argv) {
    static const char *scene_name = "all", *folder = "bench/data", *out = "build/out/roofline";
    static const study_option table[] = {
        {"scene", STUDY_CHOICE, &scene_name, 0, 0, "all|bed|drum|gas|limits", "what to measure"},
        {"steps", STUDY_INT, &steps_asked, 0, 1e8, "", "steps of one turn, 0: by scene"},
        {"turns", STUDY_INT, &turns_asked, 1, BENCH_MOST_LOOPS, "", "turns, of which the median is printed"},
        {"l2", STUDY_REAL, &second_kib, 1, 1e9, "KiB", "L2 per core: a larger world is in L3"},
        {"l3", STUDY_REAL, &third_kib, 1, 1e9, "KiB", "L3 available to one core"},
        {"data", STUDY_TEXT, &folder, 0, 0, "", "folder of start states"},
        {"out", STUDY_TEXT, &out, 0, 0, "", "folder of results"},
    };
    static const char *const names[3] = {"bed", "drum", "gas"};
    const double load = bench_load();
    int i;
    study_options(argc, argv, "Phases of a step beside the arithmetic and bandwidth limits of the machine.", table, (int)(sizeof table/sizeof *table));
    study_begin(out);
    bench_machine();
    measure_limits();
    page = bench_page_open();
    if (page) {
        bench_page_machine(page, load);
        fprintf(page, "| limit of one core | value | unit |\n|---|---|---|\n");
        for (i = 0; i < LEVELS; i++) fprintf(page, "| triad, %s | %.3g | GB/s |\n", level_names[i], 1e-9*bandwidth[i]);
        fprintf(page, "| multiply-adds | %.1f | GFLOP/s |\n| exact 1/sqrt | %.2f | G/s |\n\n"
                "| scene | phase | time per bead and step [ns] | GFLOP/s | GB/s | of the roof [%%] | limit |\n"
                "|---|---|---|---|---|---|---|\n", 1e-9*peak, 1e-9*roots);
    }
    counts = study_open("counts.md");
    if (counts) fprintf(counts, "| scene | phase | flops per bead and step | bytes per bead and step | flops per byte |\n"
                        "|---|---|---|---|---|\n");
    data = bench_data_open("roofline_counts.csv", "make bench-pages PAGES=roofline",
                           "scene,phase,flops [per bead and step],bytes [per bead and step],flops per byte");
    for (i = 0; i < 3; i++)
        if (!strcmp(scene_name, "all") || !strcmp(scene_name, names[i])) scene_place(folder, names[i]);
    study_close(page, "page.md");
    study_close(counts, "counts.md");
    study_close(data, "roofline_counts.csv");
    return study_end();
}
