/* parallel.c - what threads and slabs gain, how the cost of a grain grows with their number, and how the
   searches compare: beside the figures that [ALK07] and [MIL] printed. MIT licence.

   make bench-parallel                      the default: a few minutes
   build/parallel --part bed --threads 2    one part of it; --short for a first look, --full for all there is
   build/parallel --model                   what a cluster might do, from what slabs send: a model

   The measures are those of [ALK07] eq 3.22 to 3.24, with t_s the time of the sequential program (dem.h on
   one thread opens no parallel region at all), t_p that on P workers, both of the same steps:
       speedup     tau = t_s/t_p
       efficiency  eta = tau/P
       cost        nu  = P t_p/t_s = 1/eta       ("normalised cost")
       overhead    nu - 1
   The ways to run on several workers: threads of one world, which must give the bits of the serial run; and slabs
   (dem_slabs_create), one thread each, cut along the scene's longest or periodic axis, which after the warm-up
   must stand where the serial run does but for round-off, and keep all grains. Of slabs it also tells what they
   send: grains of a halo, bytes a border and step.
   All that is compared on a scene runs in turns, A B C A B C; medians are told (of ratios: turn by turn), with half
   the range.

   Parts:
     bed, drum, gas   the scenes of bench/scenes.h
     mill             examples/mill.c: its slice, with ledger and field as `make run` has them, and 253125
                      grains, as many as in [MIL] Fig 6.16: 45 slices side by side, without ledger and field
     tables           916, 9000, 14884 and 144400 discs, the sizes of [ALK07] Tables 3.2 to 3.4. What its text
                      says of the scene is kept: planar, alike along the width, cut into slices, 1e-5 s. What it
                      does not say is ours: the discs of its Fig 2.16 at rest in a box twice as wide as the
                      layer is high, periodic sideways
     shapes           clusters of four spheres, ellipsoids as a gas, cubes, and spheres with impulses (threads only)
     searches         Fig 2.17: discs of three sizes in a round tank (Fig 2.16), 720 N/m, e = 0.2, 1e-5 s, five
                      groups of growing number. Ours: fifths; tank of 4 m; discs of glass, 0.5 mm thick (at
                      720 N/m the weight of balls would press them through each other); no friction
     scaling          the bed, cut down to 1000 beads and laid side by side up to a million */
#define main mill_main           /* the mill is that of the study, not a copy of it                     */
#define DEM_IMPLEMENTATION
#include "examples/mill.c"
#undef main
#include "bench/measure.h"
#include "bench/scenes.h"

static const char *part = "all", *data_folder = "bench/data", *out_folder = "";
static int most_workers = 8, short_form, full_form, model_only, processors;
static double settle_asked = 0.5, span_asked, cost_asked;
static FILE *page, *csv;           /* of what a part measures, for docs/data */

/* ---- what the processors are worth ---- */

#if DEMI_OPENMP
/* Arithmetic that no memory delays: 512 sums, each of which waits for itself only. Returns one of them. */
static double count_up(double *sum, long rounds) {
    long n;
    int k;
    for (k = 0; k < 512; k++) sum[k] = k;
    for (n = 0; n < rounds; n++) {
        DEMI_ONE_BY_ONE(n);                                     /* keeps the order of the loops */
        for (k = 0; k < 512; k++) sum[k] = sum[k]*0.999 + 1;
    }
    return sum[63];
}
/* How much more arithmetic two threads do than one. Median of five turns. */
static double two_over_one(void) {
    double gain[5], seen = 0;
    int turn, way;
    for (turn = 0; turn < 5; turn++) {
        double seconds[2];
        for (way = 0; way < 2; way++) {
            const double begun = study_clock();
            int half;
            #pragma omp parallel for num_threads(2) schedule(static, 1) reduction(+:seen)
            for (half = 0; half <= way; half++) {
                double sum[512];
                seen += count_up(sum, 400000);
            }
            seconds[way] = study_clock() - begun;
        }
        gain[turn] = seen > 0 && seconds[1] > 0 ? 2*seconds[0]/seconds[1] : 0;
    }
    return bench_median(gain, 5);
}
/* s, from the moment when one thread writes a number to the moment when another one sees it: the mean of many turns. Threads
   that share a processor get a turn only when the system changes between them, so there are not more. */
static double handover(void) {
    enum { TURNS = 2000, LINE = 64 };
    int lines[3*LINE] = {0}, *turn = lines + LINE;              /* the number is alone in its cache line */
    double seconds = 0;
    #pragma omp parallel num_threads(2) shared(turn, seconds)
    {
        const int me = omp_get_thread_num(), both = omp_get_num_threads() == 2;
        double begun = 0, ended = 0;
        int seen, k;
        for (k = 0; k < TURNS && both; k++) {
            do {
                #pragma omp atomic read
                seen = *turn;
            } while (seen%2 != me);
            if (k == 1) begun = study_clock();
            if (k == TURNS - 1) ended = study_clock();
            #pragma omp atomic write
            *turn = seen + 1;
        }
        if (!me) seconds = ended - begun;
    }
    return seconds/(2*(TURNS - 2));
}
#endif
/* What limits threads whatever they compute: how much arithmetic two of them do, and how long a number takes from one to the
   other. */
static void processors_part(void) {
#if DEMI_OPENMP
    const double two = two_over_one(), one_way = handover();
    bench_result_short("two_threads.arithmetic", two, "of one thread");
    bench_result_short("two_threads.handover", 1e9*one_way, "ns until a thread sees what another wrote");
    if (page) fprintf(page, "Two threads do %.2f times the arithmetic of one. One sees what the other wrote after %.0f ns.\n\n", two,
                      1e9*one_way);
#endif
}

/* ---- what is timed: a subject, and the ways to run it ---- */

typedef struct subject {
    const char *name;            /* of the results */
    int count, warm_up, axis;    /* grains; untimed steps; slabs are cut along 0, 1, 2: x, y, z */
    const void *scene;
    dem_world *(*world)(const struct subject *s, int threads); /* null and a sentence when refused */
} subject;

/* A way to run a subject on several workers. start builds what runs, null and a sentence when it cannot; steps runs
   it; world answers its state as one world, to be looked at, or null. */
typedef struct way {
    const char *name, *worker;
    int same_bits;               /* as the serial run, promised; else the same but for round-off */
    void *(*start)(const subject *s, int workers);
    dem_result (*steps)(void *run, int count);
    const char *(*error)(const void *run);
    const dem_world *(*world)(void *run);
    void (*stop)(void *run);
} way;

static int threads_missing(int workers, const char *worker) {
    if (workers > 1 && !DEMI_OPENMP) printf("SKIP: built without OpenMP, nothing on %d %ss\n", workers, worker);
    return workers > 1 && !DEMI_OPENMP;
}
static void *threads_start(const subject *s, int workers) {
    return threads_missing(workers, "thread") ? 0 : s->world(s, workers);
}
static dem_result threads_steps(void *run, int count) { return dem_world_step((dem_world *)run, count); }
static const char *threads_error(const void *run) { return dem_world_error_get((const dem_world *)run); }
static const dem_world *threads_world(void *run) { return (const dem_world *)run; }
static void threads_stop(void *run) { dem_world_destroy((dem_world *)run); }

/* Slabs, and the world they were dealt from and are collected into. */
typedef struct dealt {
    dem_slabs *slabs;
    dem_world *world;
    int count;
    double steps, lists, bytes;  /* at the end of the warm-up */
} dealt;

static double slabs_bytes(const dealt *d) { /* sent so far, by all */
    double sum = 0;
    dem_slab slab;
    int k;
    memset(&slab, 0, sizeof slab);
    for (k = 0; k < d->count; k++) if (dem_slab_get(d->slabs, k, &slab) == DEM_OK) sum += (double)slab.bytes;
    return sum;
}
static void slabs_stop(void *run) {
    dealt *d = (dealt *)run;
    dem_slabs_destroy(d->slabs);
    dem_world_destroy(d->world);
    free(d);
}
static void *slabs_start(const subject *s, int workers) {
    dem_slabs_desc desc = DEM_SLABS_DESC;
    dealt *d;
    if (threads_missing(workers, "slab")) return 0;
    d = (dealt *)study_alloc(1, sizeof *d);
    d->count = desc.count = workers;
    desc.axis = s->axis;
    d->world = s->world(s, workers);
    d->slabs = d->world ? dem_slabs_create(d->world, &desc) : 0;
    if (d->slabs) return d;
    if (d->world) printf("SKIP: %s: %s\n", s->name, dem_world_error_get(d->world));
    slabs_stop(d);
    return 0;
}
static dem_result slabs_steps(void *run, int count) {
    dealt *d = (dealt *)run;
    const dem_result result = dem_slabs_step(d->slabs, count);
    if (!(d->steps > 0)) { /* what is sent is counted from the warm-up on */
        d->steps = (double)dem_slabs_counters_get(d->slabs).steps;
        d->lists = (double)dem_slabs_counters_get(d->slabs).rebuilds;
        d->bytes = slabs_bytes(d);
    }
    return result;
}
static const char *slabs_error(const void *run) { return dem_slabs_error_get(((const dealt *)run)->slabs); }
static const dem_world *slabs_world(void *run) {
    dealt *d = (dealt *)run;
    return dem_slabs_collect(d->slabs, d->world) == DEM_OK ? d->world : 0;
}

static const way ways[] = {
    {"threads", "thread", 1, threads_start, threads_steps, threads_error, threads_world, threads_stop},
    {"slabs", "slab", 0, slabs_start, slabs_steps, slabs_error, slabs_world, slabs_stop},
};
enum { WAYS = (int)(sizeof ways/sizeof *ways), MOST_RUNS = 1 + 4*WAYS };
static const int worker_counts[4] = {2, 3, 4, 8};

typedef struct run { const way *how; int workers; void *self; double seconds[BENCH_MOST_LOOPS]; } run;

static double run_steps(const subject *s, run *r, int steps) { /* seconds; -1 and a sentence when it breaks */
    const double begun = study_clock();
    if (r->how->steps(r->self, steps) == DEM_OK) return study_clock() - begun;
    study_fail("%s: %s", s->name, r->how->error(r->self));
    return -1;
}
static int run_start(const subject *s, run *r, const way *how, int workers) {
    dem_result result;
    memset(r, 0, sizeof *r);
    r->how = how;
    r->workers = workers;
    r->self = how->start(s, workers);
    if (r->self && (result = how->steps(r->self, s->warm_up)) != DEM_OK) {
        if (result == DEM_ERROR_ARGUMENT && !how->same_bits) /* more slabs than fit */
            printf("SKIP: %s: %s\n", s->name, how->error(r->self));
        else study_fail("%s: %s", s->name, how->error(r->self));
        how->stop(r->self);
        r->self = 0;
    }
    return r->self != 0;
}
/* Steps of one timed loop: about a fifth of a second of the first run, no fewer than `least`. */
static int loop_steps(const subject *s, run *r, int least) {
    const double want = full_form ? 2 : short_form ? 0.1 : 0.25, once = run_steps(s, r, least);
    return once > 0 ? (int)fmin(fmax(least, least*want/once), 1e6) : 0;
}
/* All runs in turns; answers how many turns, 0 when one broke. */
static int runs_turn(const subject *s, run *runs, int count, int steps) {
    const int turns = full_form ? 9 : short_form ? 3 : 5;
    int t, r;
    for (t = 0; t < turns; t++)
        for (r = 0; r < count; r++)
            if ((runs[r].seconds[t] = run_steps(s, &runs[r], steps)) < 0) return 0;
    return turns;
}

/* ---- do two runs agree, and what do slabs send ---- */

/* Largest distance between the same grains of two worlds, nearest image; 1e300 when one is missing. */
static double grains_apart(const dem_world *a, const dem_world *b) {
    const demi_periods p = demi_periods_of(a);
    double most = 0;
    int k, e;
    if (a->bodies.count != b->bodies.count || a->bodies.slot_count != b->bodies.slot_count) return 1e300;
    for (k = 0; k < a->bodies.slot_count; k++) {
        const int i = a->bodies.slot_index[k], j = b->bodies.slot_index[k];
        if ((i < 0) != (j < 0)) return 1e300;
        for (e = 0; e < 3 && i >= 0; e++)
            most = fmax(most, fabs((double)demi_image(b->bodies.pos[4*j + e] - a->bodies.pos[4*i + e], p.half[e], p.period[e])));
    }
    return most;
}
/* After the same steps. early: soon after the start, when round-off has not been multiplied yet; answers how far
   apart grains are then, m. */
static double runs_agree(const subject *s, run *serial, run *r, int early) {
    const dem_world *a = serial->how->world(serial->self), *b = r->how->world(r->self);
    double apart = 0;
    if (!b) study_fail("%s: %s", s->name, r->how->error(r->self));
    else if (r->how->same_bits) {
        if (!early && dem_world_hash_get(a) != dem_world_hash_get(b))
            study_fail("%s: 1 and %d %ss do not agree to the last bit", s->name, r->workers, r->how->worker);
    } else if (early) {
        apart = grains_apart(a, b);
        if (!(apart < (sizeof(dem_real) == 4 ? 1e-2 : 1e-9)*(double)a->effects.radius_max))
            study_fail("%s: after %d steps on %d %ss a grain is %g m from where it is on one thread", s->name, s->warm_up,
                       r->workers, r->how->worker, apart);
    } else if (a->bodies.count != b->bodies.count)
        study_fail("%s: %d grains on one thread, %d on %d %ss", s->name, a->bodies.count, b->bodies.count, r->workers, r->how->worker);
    return apart;
}
/* What slabs send to each other, from the end of the warm-up on, to be counted between processes too. */
typedef struct sent { double halo, bytes, lists, uneven, apart; } sent; /* grains, byte: a border, both ways, and step;
                                                                     steps of a list; busiest over mean; m */
static sent slabs_sent(const dealt *d) {
    const dem_slabs_counters c = dem_slabs_counters_get(d->slabs);
    double borders = 0, busiest = 0, busy = 0;
    dem_slab slab;
    sent of;
    int k;
    memset(&of, 0, sizeof of);
    memset(&slab, 0, sizeof slab);
    for (k = 0; k < d->count; k++) {
        if (dem_slab_get(d->slabs, k, &slab) != DEM_OK) continue;
        borders += slab.lo > -1e299;         /* in a ring all slabs have one below */
        of.halo += slab.ghosts;
        busiest = fmax(busiest, slab.seconds);
        busy += slab.seconds/d->count;
    }
    if (!(borders > 0)) return of;
    of.halo /= borders;
    of.bytes = (slabs_bytes(d) - d->bytes)/fmax(1, (double)c.steps - d->steps)/borders;
    of.lists = ((double)c.steps - d->steps)/fmax(1, (double)c.rebuilds - d->lists);
    of.uneven = busiest/busy;
    return of;
}

/* ---- what [ALK07] printed: Tables 3.2 to 3.4, hours and speedups ---- */

typedef struct published { int count, workers; double single, several; const char *table; } published; /* 0: not printed */
static const published printed[] = {
    {916, 3, 0, 2.9, "3.2"}, {916, 5, 0, 4.0, "3.2"}, {916, 10, 0, 5.7, "3.2"}, {916, 15, 0, 6.1, "3.2"},
    {916, 21, 0, 5.9, "3.2"}, {916, 23, 0, 5.3, "3.2"},
    {9000, 2, 0, 3.1, "3.2"}, {9000, 3, 0, 5.3, "3.2"}, {9000, 6, 0, 17.5, "3.2"}, {9000, 10, 0, 29.0, "3.2"},
    {9000, 15, 0, 35.1, "3.2"}, {9000, 18, 0, 36.1, "3.2"}, {9000, 22, 0, 34.0, "3.2"}, {9000, 24, 0, 33.1, "3.2"},
    {14884, 3, 2.7, 7.1, "3.3"}, {14884, 5, 4.7, 19.7, "3.3"}, {14884, 6, 0, 25.0, "3.3"}, {14884, 8, 5.8, 30.0, "3.3"},
    {14884, 10, 0, 39.5, "3.3"}, {14884, 12, 7.3, 46.9, "3.3"}, {14884, 16, 8.2, 50.0, "3.3"},
    {14884, 18, 10.0, 57.3, "3.3"}, {14884, 19, 10.7, 54.4, "3.3"}, {14884, 20, 10.7, 51.7, "3.3"},
    {14884, 21, 10.7, 0, "3.3"}, {14884, 22, 10.6, 50.7, "3.3"}, {14884, 25, 10.4, 0, "3.3"},
    {144400, 2, 0, 3.6, "3.4"}, {144400, 3, 2.8, 6.9, "3.4"}, {144400, 5, 0, 16.2, "3.4"}, {144400, 7, 5.9, 37.6, "3.4"},
    {144400, 10, 0, 66.9, "3.4"}, {144400, 14, 12.3, 123.6, "3.4"}, {144400, 16, 14.1, 164.6, "3.4"},
    {144400, 18, 0, 187.2, "3.4"}, {144400, 22, 16.3, 231.5, "3.4"}, {144400, 25, 0, 203.3, "3.4"},
};
enum { PRINTED = (int)(sizeof printed/sizeof *printed) };
static const struct { int count; double span, hours; } printed_serial[] = { /* s simulated, h on one processor */
    {916, 0.1, 15.3}, {9000, 0.1, 6.43}, {14884, 0.3, 75}, {144400, 0.16, 2600}};

static const published *printed_find(int count, int workers) {
    int i;
    for (i = 0; i < PRINTED; i++)
        if (printed[i].count == count && printed[i].workers == workers) return &printed[i];
    return 0;
}
/* ", published: 2.7 on one machine, 7.1 on several" of a measure that is tau^power P^share; "" when not printed. */
static void printed_text(char *text, size_t room, int count, int workers, int measure) {
    const published *p = printed_find(count, workers);
    const double P = workers, tau[2] = {p ? p->single : 0, p ? p->several : 0};
    static const char *const where[2] = {"on one machine", "on several machines"};
    size_t used = 0;
    int k, any = 0;
    text[0] = 0;
    for (k = 0; k < 2; k++) {
        if (!(tau[k] > 0)) continue;
        used += (size_t)snprintf(text + used, room - used, "%s%.3g %s", any++ ? ", " : "published: ", measure == 0 ? tau[k]
                                 : measure == 1 ? tau[k]/P : measure == 2 ? P/tau[k] : P/tau[k] - 1, where[k]);
    }
    if (any) snprintf(text + used, room - used, " ([ALK07] Table %s)", p->table);
}

/* ---- one subject, all ways, all numbers of workers ---- */

typedef struct point { const char *scene; const way *how; int count; double serial, workers, speedup; sent of; } point;
static point points[200];
static int point_count;

static void tell_sent(int workers, const sent *of) {
    char name[64];
    snprintf(name, sizeof name, "slabs%d.halo", workers);
    bench_result_short(name, of->halo, "grains a border");
    snprintf(name, sizeof name, "slabs%d.message", workers);
    bench_result_short(name, 1e-3*of->bytes, "kB a border and step, there and back");
    snprintf(name, sizeof name, "slabs%d.grain_message", workers);
    bench_result_short(name, of->halo > 0 ? of->bytes/of->halo : 0, "byte a grain of a halo and step");
    snprintf(name, sizeof name, "slabs%d.lists", workers);
    bench_result_short(name, of->lists, "steps of a list");
    snprintf(name, sizeof name, "slabs%d.uneven", workers);
    bench_result_short(name, of->uneven, "time of the busiest over the mean");
    snprintf(name, sizeof name, "slabs%d.apart", workers);
    bench_result_short(name, of->apart, "m from the serial run, the farthest grain after the warm-up");
}
/* The point of a scene that the page shows: the most workers of a kind that have a processor each, or the fewest. */
static const point *point_shown(const char *scene, const way *how) {
    const point *best = 0;
    int i;
    for (i = 0; i < point_count; i++) {
        const point *p = &points[i];
        if (p->how != how || strcmp(p->scene, scene)) continue;
        if (!best || (p->workers > best->workers && p->workers <= processors)) best = p;
    }
    return best;
}
/* Speedups on the page: a row for each scene. All points are in speedups.csv. */
static void page_speedups(void) {
    int i;
    if (!page || !point_count) return;
    fprintf(page, "| scene | grains | one thread, million particle-steps/s | threads | their speedup | slabs | their speedup | speedup "
            "of [ALK07] on as many machines |\n|---|---|---|---|---|---|---|---|\n");
    for (i = 0; i < point_count; i++) {
        const point *p = &points[i], *on[WAYS];
        const published *print;
        int w;
        if (i && !strcmp(p->scene, points[i - 1].scene)) continue;
        fprintf(page, "| %s | %d | %.1f |", p->scene, p->count, p->serial);
        for (w = 0; w < WAYS; w++) {
            on[w] = point_shown(p->scene, &ways[w]);
            if (on[w]) fprintf(page, " %.0f | %.2f |", on[w]->workers, on[w]->speedup);
            else fprintf(page, " | |");
        }
        print = on[0] ? printed_find(p->count, (int)on[0]->workers) : 0;
        if (print && print->several > 0) fprintf(page, " %.3g |\n", print->several);
        else fprintf(page, " |\n");
    }
}
/* What slabs sent: on the page for each scene, of all points in messages.csv. */
static void tell_page_sent(void) {
    int i, any = 0;
    csv = bench_table_open("messages.csv", "scene,slabs,halo_grains_per_border,kB_per_border_and_step,byte_per_halo_grain_and_step,"
                           "steps_per_list,busiest_slab_over_mean,farthest_grain_from_serial_run_m");
    for (i = 0; i < point_count; i++) {
        const sent *of = &points[i].of;
        const double each = of->halo > 0 ? of->bytes/of->halo : 0;
        if (points[i].how->start != slabs_start) continue;
        if (csv) fprintf(csv, "%s,%.0f,%.0f,%.1f,%.0f,%.0f,%.2f,%.0e\n", points[i].scene, points[i].workers, of->halo,
                         1e-3*of->bytes, each, of->lists, of->uneven, of->apart);
        if (!page || &points[i] != point_shown(points[i].scene, points[i].how)) continue;
        if (!any++) fprintf(page, "\nData that slabs exchange, counted as if each slab were a process:\n\n| scene | slabs | grains in "
                            "the halo of a border | kB per border and step, both ways | byte per halo grain and step | steps between "
                            "rebuilds of the list | busiest slab over the mean |\n|---|---|---|---|---|---|---|\n");
        fprintf(page, "| %s | %.0f | %.0f | %.1f | %.0f | %.0f | %.2f |\n", points[i].scene, points[i].workers, of->halo,
                1e-3*of->bytes, each, of->lists, of->uneven);
    }
    study_close(csv, "messages.csv");
    csv = 0;
}
static void tell_run(const subject *s, const run *serial, const run *r, int turns, int steps, double apart) {
    static const char *const names[4] = {"speedup", "efficiency", "cost", "overhead"};
    const double tau = bench_median_ratio(serial->seconds, r->seconds, turns), P = r->workers;
    const double tp = bench_median(r->seconds, turns), values[4] = {tau, tau/P, P/tau, P/tau - 1};
    char name[64], unit[200], text[160];
    int k;
    snprintf(name, sizeof name, "%s%d.rate", r->how->name, r->workers);
    bench_result_rate(name, (double)s->count*steps/tp);
    for (k = 0; k < 4; k++) {
        printed_text(text, sizeof text, s->count, r->workers, k);
        snprintf(name, sizeof name, "%s%d.%s", r->how->name, r->workers, names[k]);
        snprintf(unit, sizeof unit, "%s%s%s%s", *text ? "(" : "", text, *text ? ")" : "",
                 processors && r->workers > processors ? *text ? " (more workers than processors)"
                 : "(more workers than processors)" : "");
        bench_result_short(name, values[k], unit);
    }
    snprintf(name, sizeof name, "%s%d.spread", r->how->name, r->workers);
    bench_result_short(name, bench_spread(r->seconds, turns), "%");
    if (csv) {
        const published *print = printed_find(s->count, r->workers);
        fprintf(csv, "%s,%d,%ss,%d,%d,%.1f,%.2f,%.2f,%.2f,%.2f,", s->name, s->count, r->how->worker, r->workers,
                processors && r->workers > processors, 1e-6*s->count*steps/tp, values[0], values[1], values[2], values[3]);
        for (k = 0; k < 2; k++) {
            const double published_tau = !print ? 0 : k ? print->several : print->single;
            if (published_tau > 0) fprintf(csv, "%.3g", published_tau);
            fputc(k ? '\n' : ',', csv);
        }
    }
    if (point_count < (int)(sizeof points/sizeof *points)) {
        point *p = &points[point_count++];
        p->scene = s->name; p->how = r->how; p->workers = P; p->speedup = values[0]; p->count = s->count;
        p->serial = 1e-6*s->count*steps/bench_median(serial->seconds, turns);
        memset(&p->of, 0, sizeof p->of);
        if (r->how->start != slabs_start) return;
        p->of = slabs_sent((const dealt *)r->self);
        p->of.apart = apart;
        tell_sent(r->workers, &p->of);
    }
}
/* What [ALK07] took for the whole run, and what these steps would: extrapolated from the time of a step. */
static void tell_span(const subject *s, double step, double dt) {
    char unit[100];
    size_t i;
    for (i = 0; i < sizeof printed_serial/sizeof *printed_serial; i++) {
        if (printed_serial[i].count != s->count) continue;
        snprintf(unit, sizeof unit, "s for %g s (published: %.0f s)", printed_serial[i].span, 3600*printed_serial[i].hours);
        bench_result_short("serial.span", printed_serial[i].span/dt*step, unit);
    }
}
static int compare_ways(const subject *s, double dt) { /* answers 0 when something broke */
    run runs[MOST_RUNS];
    double apart[MOST_RUNS] = {0};
    int count = 0, turns = 0, steps = 0, w, k, r;
    snprintf(study.prefix, sizeof study.prefix, "%s.", s->name);
    if (run_start(s, &runs[0], &ways[0], 1)) {
        count = 1;
        for (w = 0; w < WAYS; w++)
            for (k = 0; k < 4; k++)
                if (worker_counts[k] <= most_workers && run_start(s, &runs[count], &ways[w], worker_counts[k])) {
                    apart[count] = runs_agree(s, &runs[0], &runs[count], 1);
                    count++;
                }
        steps = loop_steps(s, &runs[0], short_form ? 10 : 20);
        for (r = 1; r < count && steps; r++)                     /* all take the same steps */
            if (run_steps(s, &runs[r], short_form ? 10 : 20) < 0) steps = 0;
        turns = steps ? runs_turn(s, runs, count, steps) : 0;
    }
    if (turns) {
        const double ts = bench_median(runs[0].seconds, turns);
        bench_result_rate("serial.rate", (double)s->count*steps/ts);
        bench_result_short("serial.spread", bench_spread(runs[0].seconds, turns), "%");
        if (csv) fprintf(csv, "%s,%d,serial,1,0,%.1f,1,1,1,0,,\n", s->name, s->count, 1e-6*s->count*steps/ts);
        tell_span(s, ts/steps, dt);
    }
    for (r = 1; r < count && turns; r++) {
        tell_run(s, &runs[0], &runs[r], turns, steps, apart[r]);
        runs_agree(s, &runs[0], &runs[r], 0);
    }
    for (r = 0; r < count; r++) runs[r].how->stop(runs[r].self);
    study.prefix[0] = 0;
    return turns;
}

/* ---- bed, drum, gas ---- */

static dem_world *scene_world(const subject *s, int threads) {
    bench_choice choice = BENCH_CHOICE;
    choice.threads = threads;
    return bench_world((const bench_scene *)s->scene, &choice);
}
static subject scene_subject(const char *name, const bench_scene *scene, int warm_up) {
    subject s;
    s.name = name; s.count = scene->count; s.warm_up = warm_up; s.scene = scene; s.world = scene_world;
    s.axis = bench_is(scene, "drum"); /* the drum's own axis is y */
    return s;
}
static void scene_part(const char *name) {
    bench_scene scene = bench_scene_read(data_folder, name);
    const subject s = scene_subject(name, &scene, 100);
    compare_ways(&s, scene.dt);
    bench_scene_free(&scene);
}

/* ---- the mill: a slice that has turned for a while, alone or many side by side ---- */

typedef struct slices { mill one; int count, whole; double *x, *v, *spin; } slices; /* whole: with ledger and field */

/* The slice after `settle` of a turn, rounded to a twelfth: then the twelve lifters stand as at first. It is
   kept in the folder of results, and taken from there next time. */
static int slices_settle(slices *s) {
    const double twelfths = fmax(1, floor(12*settle_asked + 0.5));
    char path[640];
    dem_bodies b;
    int steps, done, i, c;
    memset(s, 0, sizeof *s);
    program_path = "build/parallel";
    s->one.o = options;
    s->one.o.threads = 1;
    s->one.o.fill = 5625/19200.0;                                /* of the volume: 5625 beads, 45 x 5625 = 253125 */
    s->one.o.length = 0.0064;
    if (mill_begin(&s->one)) return 0;
    steps = (int)(twelfths*SAMPLES/12*s->one.sample_steps + 0.5);
    snprintf(path, sizeof path, "%s/mill_%.0f_of_12.state", study.folder, twelfths);
    if (dem_checkpoint_read(s->one.world, path) != DEM_OK || dem_world_steps_get(s->one.world) != (uint64_t)steps) {
        for (done = 0; done < steps; done += 500) {
            study_progress("mill turns", (double)done/steps, (double)s->one.grains*done);
            if (refused(s->one.world, dem_world_step(s->one.world, steps - done < 500 ? steps - done : 500))) return 0;
        }
        study_progress("mill turns", 1, (double)s->one.grains*steps);
        if (refused(s->one.world, dem_checkpoint_write(s->one.world, path))) return 0;
    }
    b = dem_bodies_get(s->one.world);
    s->x = (double *)study_alloc(3*(size_t)b.count, sizeof(double));
    s->v = (double *)study_alloc(3*(size_t)b.count, sizeof(double));
    s->spin = (double *)study_alloc(3*(size_t)b.count, sizeof(double));
    for (i = 0; i < b.count; i++)
        for (c = 0; c < 3; c++) {
            const double L = s->one.o.length;
            s->x[3*i + c] = (double)b.positions[4*i + c] - (c == 2 ? L*floor((double)b.positions[4*i + c]/L + 0.5) : 0);
            s->v[3*i + c] = (double)b.velocities[4*i + c];
            s->spin[3*i + c] = (double)b.spins[4*i + c];
        }
    return 1;
}
/* mill_create's world with the beads where they are, `count` slices long. */
static dem_world *slices_world(const subject *subject_of, int threads) {
    const slices *s = (const slices *)subject_of->scene;
    mill m = s->one;
    dem_world_desc desc = DEM_WORLD_DESC;
    const double R = m.o.diameter/2, L = m.o.length*s->count;
    const int n = s->one.grains;
    dem_real *x = (dem_real *)study_alloc(3*(size_t)subject_of->count, sizeof *x);
    dem_real *v = (dem_real *)study_alloc(3*(size_t)subject_of->count, sizeof *v);
    int i, k, bad;
    m.o.length = L;
    desc.gravity.y = (dem_real)-GRAVITY;
    desc.impact_speed = (dem_real)(m.omega*R);
    desc.threads = threads;
    desc.ledger = s->whole;
    desc.dt = (dem_real)m.dt;
    desc.domain = dem_box_make((dem_real)(-1.1*R), (dem_real)(-1.1*R), (dem_real)(-L/2), (dem_real)(1.1*R),
                               (dem_real)(1.1*R), (dem_real)(L/2));
    desc.boundary[2] = DEM_BOUNDARY_PERIODIC;
    for (k = 0; k < s->count; k++)
        for (i = 0; i < 3*n; i++) {
            x[3*n*k + i] = (dem_real)(s->x[i] + (i%3 == 2 ? (k + 0.5)*L/s->count - L/2 : 0));
            v[3*n*k + i] = (dem_real)s->v[i];
        }
    m.world = 0;
    m.profile.vertices = 0;
    m.profile.segments = 0;
    bad = world_create(&m, &desc) || materials_add(&m) || shell_add(&m) ||
          refused(m.world, dem_spheres_add(m.world, m.glass, subject_of->count, x, v, 0, (dem_real)m.o.radius));
    for (i = 0; i < subject_of->count && !bad; i++) {
        const dem_body body = dem_body_id_get(m.world, i);
        dem_body_state state;
        bad = refused(m.world, dem_body_get(m.world, body, &state));
        state.spin = dem_vec3_make((dem_real)s->spin[3*(i%n)], (dem_real)s->spin[3*(i%n) + 1], (dem_real)s->spin[3*(i%n) + 2]);
        bad = bad || refused(m.world, dem_body_set(m.world, body, &state));
    }
    if (s->whole && !bad) {
        dem_field_desc field;
        memset(&field, 0, sizeof field);
        field.box = dem_box_make((dem_real)-R, (dem_real)-R, (dem_real)(-L/2), (dem_real)R, (dem_real)R, (dem_real)(L/2));
        field.cells[0] = field.cells[1] = CELLS;
        field.cells[2] = 1;
        field.interval = m.period/720;
        bad = !dem_field_add(m.world, &field).id;
    }
    free(x); free(v);
    dem_profile_free(m.world, &m.profile);
    if (!bad) return m.world;
    dem_world_destroy(m.world);
    return 0;
}
static void mill_part(void) {
    slices s;
    subject of;
    int most = most_workers;
    if (!slices_settle(&s)) return;
    of.name = "mill"; of.count = s.one.grains; of.warm_up = 200; of.scene = &s; of.world = slices_world;
    of.axis = 0; /* across the slice: it is too short for slabs along the mill's axis, z */
    s.count = s.whole = 1;
    compare_ways(&of, s.one.dt);
    if (!short_form) {
        if (!full_form) most_workers = most < 2 ? most : 2;
        of.name = "mill253125"; of.count = 45*s.one.grains; of.warm_up = 40; s.count = 45; s.whole = 0;
        of.axis = 2;
        study_result_text("mill253125.published", "18.35e6", "particle-steps/s ([MIL] Fig 6.16, GTX 560 Ti, double precision; "
                          "others there 2.02e4 to 4.74e6)");
        compare_ways(&of, s.one.dt);
        most_workers = most;
    }
    free(s.x); free(s.v); free(s.spin);
    mill_destroy(&s.one);
}

/* ---- discs: [ALK07] 2.3.2 and 3.6 ---- */

typedef struct discs {
    int count;
    double *x, *y, *u, *v, *r;    /* m, m/s */
    double width, tank;          /* m: of the periodic box on a floor; radius of the round tank; one is 0 */
    dem_search search;
} discs;
#define DISC_STIFFNESS 720.0     /* N/m [ALK07] */
#define DISC_RESTITUTION 0.2     /* [ALK07] */
#define DISC_DT 1e-5             /* s [ALK07] */
#define DISC_THICKNESS 5e-4      /* m, of glass, 2500 kg/m3: ours */
#define DISC_TANK 2.0            /* m, radius: ours */

static uint32_t disc_random = 1;
static double disc_uniform(void) {
    disc_random = disc_random*1664525u + 1013904223u;
    return (disc_random >> 8)/16777216.0;
}
static void discs_allocate(discs *d, int count) {
    d->count = count;
    d->x = (double *)study_alloc((size_t)count, sizeof(double));
    d->y = (double *)study_alloc((size_t)count, sizeof(double));
    d->u = (double *)study_alloc((size_t)count, sizeof(double));
    d->v = (double *)study_alloc((size_t)count, sizeof(double));
    d->r = (double *)study_alloc((size_t)count, sizeof(double));
}
static void discs_free(discs *d) { free(d->x); free(d->y); free(d->u); free(d->v); free(d->r); }

/* Rows of discs of 10, 15 and 20 mm in the shares 2278 : 1716 : 342, mixed at random; in the tank's middle, or
   above the floor of a box. */
static discs discs_make(int count, int round) {
    static const double radius[3] = {0.010, 0.015, 0.020};
    const double share[3] = {2278/4336.0, 1716/4336.0, 342/4336.0};
    discs d;
    double width = sqrt(count*0.0265*0.041*(round ? 1 : 3)), x = 0, y = 0;
    int left[3], i, k;
    memset(&d, 0, sizeof d);
    discs_allocate(&d, count);
    d.width = round ? 0 : width;
    d.tank = round ? DISC_TANK : 0;
    left[2] = (int)(share[2]*count + 0.5);
    left[1] = (int)(share[1]*count + 0.5);
    left[0] = count - left[1] - left[2];
    disc_random = 1;
    for (i = 0; i < count; i++) {
        double at = disc_uniform()*(count - i);
        for (k = 0; k < 2 && at >= left[k]; k++) at -= left[k];
        left[k]--;
        d.r[i] = radius[k];
        if (x + 2.04*d.r[i] > width) { x = 0; y += 0.041; }
        d.x[i] = x + 1.02*d.r[i];
        d.y[i] = y + 0.0205;
        d.u[i] = 0.2*(disc_uniform() - 0.5);
        x += 2.04*d.r[i];
    }
    for (i = 0; i < count && round; i++) { d.x[i] -= width/2; d.y[i] -= (y + 0.041)/2; }
    return d;
}
static dem_world *discs_world_at(const discs *d, int threads, double dt) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc glass = DEM_MATERIAL_DESC;
    dem_material material;
    dem_pair pair;
    dem_world *world;
    dem_real *x = (dem_real *)study_alloc(3*(size_t)d->count, sizeof *x), *v, *r;
    int i, ok;
    v = (dem_real *)study_alloc(3*(size_t)d->count, sizeof *v);
    r = (dem_real *)study_alloc((size_t)d->count, sizeof *r);
    desc.gravity.y = DEM_R(-9.81);
    desc.planar = 1;
    desc.thickness = DEM_R(DISC_THICKNESS);
    desc.normal_law = DEM_NORMAL_LINEAR;
    desc.dt = (dem_real)dt;
    desc.threads = threads;
    desc.search = d->search;
    if (d->width > 0) {
        desc.boundary[0] = DEM_BOUNDARY_PERIODIC;
        desc.domain = dem_box_make(0, -1, -1, (dem_real)d->width, 1000, 1);
    }
    world = dem_world_create(&desc);
    if (!world) { study_fail("discs: %s", dem_world_create_error_get(&desc)); free(x); free(v); free(r); return 0; }
    glass.density = 2500;
    glass.stiffness = DEM_R(DISC_STIFFNESS);
    glass.restitution = DEM_R(DISC_RESTITUTION);
    material = dem_material_add(world, &glass);
    ok = material.id && dem_pair_get(world, material, material, &pair) == DEM_OK;
    if (ok) pair.stiffness = DEM_R(DISC_STIFFNESS); /* of the pair, not two in series */
    ok = ok && dem_pair_set(world, material, material, &pair) == DEM_OK;
    ok = ok && (d->tank > 0 ? dem_wall_cylinder_add(world, material, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1),
                                               (dem_real)d->tank, 1).id
                            : dem_wall_plane_add(world, material, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 1, 0)).id);
    for (i = 0; i < d->count; i++) {
        x[3*i] = (dem_real)d->x[i]; x[3*i + 1] = (dem_real)d->y[i];
        v[3*i] = (dem_real)d->u[i]; v[3*i + 1] = (dem_real)d->v[i];
        r[i] = (dem_real)d->r[i];
    }
    if (ok && dem_spheres_add(world, material, d->count, x, v, r, 0) == DEM_OK) ok = 2;
    free(x); free(v); free(r);
    if (ok == 2) return world;
    study_fail("discs: %s", dem_world_error_get(world));
    dem_world_destroy(world);
    return 0;
}
static dem_world *discs_world(const subject *s, int threads) {
    return discs_world_at((const discs *)s->scene, threads, DISC_DT);
}
/* Lets them fall for a while, in longer steps: t_c is 1.8 ms. */
static int discs_fall(discs *d, double seconds) {
    dem_world *world = discs_world_at(d, 1, 8*DISC_DT);
    dem_bodies b;
    int i;
    if (!world) return 0;
    if (dem_world_step(world, (int)(seconds/(8*DISC_DT) + 0.5)) != DEM_OK) {
        study_fail("discs: %s", dem_world_error_get(world));
        dem_world_destroy(world);
        return 0;
    }
    b = dem_bodies_get(world);
    for (i = 0; i < b.count; i++) {
        const size_t to = dem_body_id_get(world, i).slot - 1;
        d->x[to] = (double)b.positions[4*i];
        d->y[to] = (double)b.positions[4*i + 1];
        if (d->width > 0) d->x[to] -= d->width*floor(d->x[to]/d->width);
        d->u[to] = (double)b.velocities[4*i];
        d->v[to] = (double)b.velocities[4*i + 1];
    }
    dem_world_destroy(world);
    return 1;
}
static discs discs_tile(const discs *d, int tiles) { /* side by side */
    discs all = *d;
    int i;
    discs_allocate(&all, d->count*tiles);
    all.width = d->width*tiles;
    for (i = 0; i < all.count; i++) {
        const int k = i%d->count;
        all.x[i] = d->x[k] + d->width*(i/d->count);
        all.y[i] = d->y[k]; all.u[i] = d->u[k]; all.v[i] = d->v[k]; all.r[i] = d->r[k];
    }
    return all;
}
static void tables_part(void) {
    static const struct { const char *name; int tiles; } sizes[] = {
        {"discs916", 1}, {"discs9000", 9}, {"discs14884", 4}, {"discs144400", 40}};
    size_t i;
    for (i = 0; i < sizeof sizes/sizeof *sizes; i++) {
        const int count = printed_serial[i].count;
        discs one = discs_make(count/sizes[i].tiles, 0), all;
        subject s;
        if (discs_fall(&one, 0.5)) {
            all = discs_tile(&one, sizes[i].tiles);
            s.name = sizes[i].name; s.count = all.count; s.warm_up = 100; s.scene = &all; s.world = discs_world;
            s.axis = 0;
            compare_ways(&s, DISC_DT);
            discs_free(&all);
        }
        discs_free(&one);
    }
}

/* ---- searches: time of a simulated second against the number of discs, [ALK07] Fig 2.17 ---- */

enum { SEARCHES = 5, GROUPS = 5 };
static const struct { dem_search search; const char *name, *about; } searches[SEARCHES] = {
    {DEM_SEARCH_GRID, "verlet_grid", "Verlet list from a grid"},
    {DEM_SEARCH_LINKED_LIST, "linked_list", "linked linear list"},
    {DEM_SEARCH_ALL_PAIRS, "verlet_all_pairs", "Verlet list, all pairs tested, as in [ALK07]"},
    {DEM_SEARCH_HIERARCHICAL, "hierarchical", "Verlet list from a hierarchical grid"},
    {DEM_SEARCH_BINS, "bins", "Verlet list from bins of boxes, as in Critelli 2014"}};

/* Seconds of wall time per simulated second of each search, from here on; medians of several turns. */
static int search_here(discs *d, int steps, int turns, double seconds[SEARCHES], double rebuilds[SEARCHES]) {
    double t[SEARCHES][BENCH_MOST_LOOPS];
    dem_world *worlds[SEARCHES] = {0};
    int k, r, done, ok = 1;
    for (k = 0; k < SEARCHES && ok; k++) {
        d->search = searches[k].search;
        worlds[k] = discs_world_at(d, 1, DISC_DT);
        ok = worlds[k] && (full_form || dem_world_step(worlds[k], 50) == DEM_OK);
    }
    for (r = 0; r < turns && ok; r++)
        for (k = 0; k < SEARCHES && ok; k++) {
            const double begun = study_clock();
            for (done = 0; done < steps && ok; done += 500) {
                ok = dem_world_step(worlds[k], steps - done < 500 ? steps - done : 500) == DEM_OK;
                if (full_form) study_progress(searches[k].name, fmin(1, (done + 500.0)/steps), (double)d->count*(done + 500));
            }
            t[k][r] = (study_clock() - begun)/(steps*DISC_DT);
        }
    for (k = 0; k < SEARCHES; k++) {
        if (worlds[k] && !ok) study_fail("%s: %s", searches[k].name, dem_world_error_get(worlds[k]));
        if (ok) {
            const dem_counters c = dem_counters_get(worlds[k]);
            seconds[k] = bench_median(t[k], turns);
            rebuilds[k] = (double)c.steps/(double)(c.rebuilds ? c.rebuilds : 1);
        }
        if (worlds[k]) dem_world_destroy(worlds[k]);
    }
    d->search = DEM_SEARCH_AUTO;
    return ok;
}
/* The mean of spans after 0.5, 1 and 2 s; --full: the whole 4 s, as in [ALK07]. */
static int search_group(int count, double seconds[SEARCHES], double rebuilds[SEARCHES]) {
    static const double falls[3] = {0.5, 0.5, 1};
    const int spans = short_form ? 1 : 3;
    const int steps = (int)((span_asked > 0 ? span_asked : short_form ? 0.005 : 0.03)/spans/DISC_DT + 0.5);
    discs d = discs_make(count, 1);
    double t[SEARCHES], n[SEARCHES];
    int i, k, ok = 1;
    if (full_form) ok = search_here(&d, (int)(4/DISC_DT + 0.5), 1, seconds, rebuilds);
    else {
        for (k = 0; k < SEARCHES; k++) seconds[k] = rebuilds[k] = 0;
        for (i = 0; i < spans && ok; i++) {
            ok = discs_fall(&d, falls[i]) && search_here(&d, steps, 3, t, n);
            for (k = 0; k < SEARCHES && ok; k++) { seconds[k] += t[k]/spans; rebuilds[k] += n[k]/spans; }
        }
    }
    discs_free(&d);
    return ok;
}
static void searches_part(void) {
    static double number[GROUPS], seconds[SEARCHES][GROUPS];
    study_figure f;
    char name[64], unit[96];
    int g, k, groups = 0;
    if (page) {
        fprintf(page, "\nContact search in the scene of [ALK07] Fig 2.17, one thread, s of wall time per simulated s:\n\n| discs |");
        for (k = 0; k < SEARCHES; k++) fprintf(page, " %s |", searches[k].about);
        fputs("\n|---|", page);
        for (k = 0; k < SEARCHES; k++) fputs("---|", page);
        fputc('\n', page);
    }
    for (g = 0; g < GROUPS; g++) {
        double t[SEARCHES], rebuilds[SEARCHES];
        if (short_form && g + 1 < GROUPS) continue;
        number[groups] = (4336*(g + 1) + 2)/5;
        if (!search_group((int)number[groups], t, rebuilds)) return;
        for (k = 0; k < SEARCHES; k++) {
            seconds[k][groups] = t[k];
            snprintf(name, sizeof name, "discs%.0f.%s.time", number[groups], searches[k].name);
            snprintf(unit, sizeof unit, "s per simulated s (%.0f steps per list)", rebuilds[k]);
            bench_result_short(name, t[k], unit);
        }
        snprintf(name, sizeof name, "discs%.0f.linked_list.vs_grid", number[groups]);
        bench_result_short(name, t[1]/t[0], "times as long");
        snprintf(name, sizeof name, "discs%.0f.linked_list.vs_all_pairs", number[groups]);
        bench_result_short(name, t[1]/t[2], "times as long (published: below 1)");
        if (page) fprintf(page, "| %.0f |", number[groups]);
        for (k = 0; k < SEARCHES && page; k++) fprintf(page, " %.1f |", t[k]);
        if (page) fputc('\n', page);
        groups++;
    }
    if (groups < 2) return;
    memset(&f, 0, sizeof f);
    f.title = "Discs in a round tank: cost of a simulated second";
    f.x_label = "discs";
    f.y_label = "wall time, s per simulated s";
    for (k = 0; k < SEARCHES; k++) study_curve(&f, searches[k].about, STUDY_LINE, groups, number, seconds[k]);
    study_figure_write(&f, "searches.svg");
}

/* ---- other bodies, and the other response ---- */

/* Bodies that fall onto a floor, in a box that is periodic along x and y; or a gas without gravity and floor. The box has the
   volume of `count` spheres of `radius` (m) over `fraction`; of ellipsoids, that of the ellipsoids. fall: s. */
typedef struct heap { const char *name; int count, gas, impulses; double radius, fraction, fall; } heap;
static const heap heaps[] = {
    {"clusters", 4096, 0, 0, 2e-3, 0.12, 0.15},                  /* of four spheres */
    {"ellipsoid_gas", 4096, 1, 0, 2e-3, 0.058, 0.01},            /* 1 : 1 : 2, solid fraction of [RUB15] */
    {"cubes", 4096, 0, 0, 2e-3, 0.12, 0.1},
    {"impulses", 8192, 0, 1, 2e-3, 0.3, 0.3},                    /* spheres */
};
enum { HEAPS = (int)(sizeof heaps/sizeof *heaps) };

static dem_shape heap_shape(const heap *h, dem_world *world) {
    static const dem_real four[12] = {1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1};
    const dem_real r = (dem_real)h->radius;
    dem_real corners[24];
    dem_shape none = {0};
    int i;
    if (h->gas) return dem_shape_ellipsoid_add(world, dem_vec3_make(r, r, 2*r));
    if (h->impulses) return none;
    for (i = 0; i < 24; i++) corners[i] = r*(i/3 >> i%3 & 1 ? DEM_R(0.8) : DEM_R(-0.8));
    if (!strcmp(h->name, "cubes")) return dem_shape_polyhedron_add(world, 8, corners);
    else {
        dem_cluster_desc desc = DEM_CLUSTER_DESC;
        for (i = 0; i < 12; i++) corners[i] = DEM_R(0.4)*r*four[i];
        desc.count = 4;
        desc.positions = corners;
        desc.radius = DEM_R(0.6)*r;
        return dem_shape_cluster_add(world, &desc);
    }
}
/* The scene without bodies. */
static dem_world *heap_begin(const heap *h, int threads, dem_material *material, dem_shape *shape, dem_box *box) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = DEM_MATERIAL_DESC;
    const double volume = (h->gas ? 2 : 1)*4*PI/3*pow(h->radius, 3)*h->count/h->fraction, side = cbrt(h->gas ? volume : volume/2);
    dem_world *world;
    int ok;
    *box = dem_box_make(0, 0, 0, (dem_real)side, (dem_real)side, (dem_real)(h->gas ? side : 2*side));
    desc.domain = *box;
    desc.boundary[0] = desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
    if (h->gas) desc.boundary[2] = DEM_BOUNDARY_PERIODIC;
    else desc.gravity.z = DEM_R(-9.81);
    desc.response = h->impulses ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS;
    if (h->impulses) desc.dt = DEM_R(2.5e-4);
    desc.threads = threads;
    desc.impact_speed = 1;
    world = dem_world_create(&desc);
    if (!world) { study_fail("%s: %s", h->name, dem_world_create_error_get(&desc)); return 0; }
    stuff.density = 2500;
    stuff.young = DEM_R(1e7);
    stuff.friction = DEM_R(0.4);
    stuff.restitution = h->gas ? DEM_R(0.95) : DEM_R(0.5);
    *material = dem_material_add(world, &stuff);
    *shape = heap_shape(h, world);
    ok = material->id && (h->impulses || shape->id) &&
        (h->gas || dem_wall_plane_add(world, *material, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1)).id);
    if (ok) return world;
    study_fail("%s: %s", h->name, dem_world_error_get(world));
    dem_world_destroy(world);
    return 0;
}
static const char *heap_path(const heap *h) {
    char name[64];
    snprintf(name, sizeof name, "%s.state", h->name);
    return study_path(name);
}
/* Fills the box, lets the bodies fall, and saves the state. Returns how many they are; 0 if something broke. */
static int heap_fall(const heap *h) {
    dem_material material;
    dem_shape shape;
    dem_box box;
    dem_world *world = heap_begin(h, 0, &material, &shape, &box);
    int count = 0, i, k;
    if (!world) return 0;
    box.lo.z = (dem_real)h->radius;
    count = h->impulses ? dem_spheres_fill(world, material, (dem_real)h->radius, dem_region_make(box), h->count, 1)
        : dem_bodies_fill(world, material, shape, dem_region_make(box), h->count, 1);
    disc_random = 1;
    for (i = 0; i < count && h->gas; i++) {
        dem_body_state state;
        dem_real v[3];
        for (k = 0; k < 3; k++) v[k] = (dem_real)(disc_uniform() - 0.5);
        dem_body_get(world, dem_body_id_get(world, i), &state);
        state.velocity = dem_vec3_make(v[0], v[1], v[2]);
        dem_body_set(world, dem_body_id_get(world, i), &state);
    }
    while (count > 0 && dem_world_time_get(world) < (short_form ? 0.1 : 1)*h->fall)
        if (dem_world_step(world, 20) != DEM_OK) count = 0;
    if (count < 1 || dem_checkpoint_write(world, heap_path(h)) != DEM_OK) {
        study_fail("%s: %s", h->name, dem_world_error_get(world));
        count = 0;
    }
    dem_world_destroy(world);
    return count;
}
static dem_world *heap_world(const subject *s, int threads) {
    const heap *h = (const heap *)s->scene;
    dem_material material;
    dem_shape shape;
    dem_box box;
    dem_world *world = heap_begin(h, threads, &material, &shape, &box);
    if (!world || dem_checkpoint_read(world, heap_path(h)) == DEM_OK) return world;
    study_fail("%s: %s", h->name, dem_world_error_get(world));
    dem_world_destroy(world);
    return 0;
}
static void shapes_part(void) {
    int i;
    for (i = 0; i < HEAPS; i++) {
        subject of;
        of.name = heaps[i].name; of.warm_up = 40; of.axis = 0; of.scene = &heaps[i]; of.world = heap_world;
        of.count = heap_fall(&heaps[i]);
        if (of.count) compare_ways(&of, 1);
        remove(heap_path(&heaps[i]));
    }
}

/* ---- scaling: what a bead costs in beds of a thousand to a million ---- */

/* Seams leave gaps: a cut bed sinks for 50 ms, and comes to rest in 10 more, with drag. */
static dem_vec3 bed_drag(dem_vec3 x, dem_vec3 v, dem_real radius, dem_real mass, double time, void *user) {
    const dem_real c = (time < 0.05 ? -20 : -500)*mass;
    (void)x; (void)radius; (void)user;
    return dem_vec3_make(c*v.x, c*v.y, c*v.z);
}
static void bed_rest(bench_scene *s) {
    bench_choice choice = BENCH_CHOICE;
    dem_world *world;
    choice.force = bed_drag;
    world = bench_world(s, &choice);
    if (!world) return;
    if (dem_world_step(world, (int)(0.06/s->dt)) != DEM_OK) study_fail("bed: %s", dem_world_error_get(world));
    bench_scene_take(s, world);
    memset(s->v, 0, 3*(size_t)s->count*sizeof *s->v);
    memset(s->spin, 0, 3*(size_t)s->count*sizeof *s->spin);
    dem_world_destroy(world);
}
/* The part of the bed with x and y below `share` of its sides; beads that would then overlap across the new
   seams are left out. */
static bench_scene bed_cut(const bench_scene *bed, double share) {
    bench_scene s = bench_scene_make("bed", bed->count);
    const double d2 = 4*bed->radius*bed->radius, side = share*bed->side[0];
    int i, k, n = 0;
    s.side[0] = s.side[1] = side;
    for (i = 0; i < bed->count; i++) {
        const double *p = bed->x + 3*i;
        int meets = p[0] >= side || p[1] >= side;
        for (k = 0; k < n && !meets; k++) {
            const double *q = s.x + 3*k;
            double dx = fabs(p[0] - q[0]), dy = fabs(p[1] - q[1]), dz = p[2] - q[2];
            const int seam = 2*dx > side || 2*dy > side;
            dx = fmin(dx, side - dx);
            dy = fmin(dy, side - dy);
            meets = seam && dx*dx + dy*dy + dz*dz < d2;
        }
        if (meets) continue;
        memcpy(s.x + 3*n++, p, 3*sizeof *p);
    }
    s.count = n;
    bed_rest(&s);
    return s;
}
static bench_scene bed_tile(const bench_scene *bed, int nx, int ny) {
    bench_scene s = bench_scene_make("bed", bed->count*nx*ny);
    int i;
    s.side[0] = nx*bed->side[0];
    s.side[1] = ny*bed->side[1];
    for (i = 0; i < s.count; i++) {
        const int tile = i/bed->count, k = i%bed->count;
        s.x[3*i] = bed->x[3*k] + tile%nx*bed->side[0];
        s.x[3*i + 1] = bed->x[3*k + 1] + tile/nx*bed->side[1];
        s.x[3*i + 2] = bed->x[3*k + 2];
    }
    return s;
}
static const struct { int asked, nx, ny; } beds[] = {{1000, 0, 0}, {2000, 0, 0}, {5000, 0, 0}, {10000, 0, 0}, {20000, 1, 1},
    {40000, 2, 1}, {100000, 5, 1}, {200000, 5, 2}, {500000, 5, 5}, {1000000, 10, 5}};
enum { BEDS = (int)(sizeof beds/sizeof *beds) };

static void scaling_part(void) {
    static double number[BEDS], cost[1 + MOST_RUNS][BEDS];
    static char legend[1 + MOST_RUNS][32];
    bench_scene bed = bench_scene_read(data_folder, "bed");
    study_figure f;
    int i, k, w, r, done = 0, lines = 0;
    if (page) fprintf(page, "\nThe bed at other sizes:\n\n| beads | contacts per bead | one thread, ns per bead and step | the same over "
                      "that at 20000 | largest speedup | on |\n|---|---|---|---|---|---|\n");
    for (i = 0; i < BEDS; i++) {
        bench_scene s;
        subject of, reference = scene_subject("bed", &bed, 100);
        run runs[1 + MOST_RUNS]; /* the first is the bed of 20000, for comparison in turns */
        int count = 0, steps = 0, turns = 0, t, reference_steps;
        char name[64], fastest[64] = "";
        double tau = 0, speedup, ns[1 + MOST_RUNS], growth = 0;
        if (short_form && (beds[i].asked < 20000 || beds[i].asked > 100000)) continue;
        s = beds[i].nx ? bed_tile(&bed, beds[i].nx, beds[i].ny) : bed_cut(&bed, sqrt(beds[i].asked/(double)bed.count));
        of = scene_subject("bed", &s, i < 5 ? 100 : 40);
        if (run_start(&reference, &runs[0], &ways[0], 1) && run_start(&of, &runs[1], &ways[0], 1)) {
            count = 2;
            for (w = 0; w < WAYS; w++)
                for (k = 0; k < 4; k++)
                    if (worker_counts[k] <= most_workers && (full_form || worker_counts[k] <= 2))
                        count += run_start(&of, &runs[count], &ways[w], worker_counts[k]);
            steps = loop_steps(&of, &runs[1], i < 9 ? 20 : 12);
        } else if (count == 0 && runs[0].self) ways[0].stop(runs[0].self);
        reference_steps = (int)fmax(10, (double)steps*s.count/bed.count);
        for (t = 0; t < (full_form ? 7 : 3) && steps; t++, turns = t)
            for (r = 0; r < count && steps; r++) {
                runs[r].seconds[t] = run_steps(r ? &of : &reference, &runs[r], r ? steps : reference_steps);
                if (runs[r].seconds[t] < 0) steps = 0;
            }
        for (r = 0; r < count && steps; r++)
            ns[r] = 1e9*bench_median(runs[r].seconds, turns)/((double)(r ? steps : reference_steps)*(r ? s.count : bed.count));
        if (steps) growth = bench_median_ratio(runs[1].seconds, runs[0].seconds, turns)*reference_steps*bed.count/((double)steps*s.count);
        for (r = 1; r < count && steps; r++) {
            cost[r - 1][done] = ns[r];
            if (r - 1 >= lines) snprintf(legend[lines++], sizeof *legend, r > 1 ? "%d %ss" : "serial", runs[r].workers, runs[r].how->worker);
            if (r == 1) {
                const double touches = 2.0*dem_counters_get((dem_world *)runs[1].self).contacts/s.count;
                snprintf(name, sizeof name, "bed.n%d.count", beds[i].asked);
                study_result(name, s.count, "beads");
                snprintf(name, sizeof name, "bed.n%d.contacts_per_bead", beds[i].asked);
                bench_result_short(name, touches, "");
                snprintf(name, sizeof name, "bed.n%d.time", beds[i].asked);
                bench_result_short(name, ns[1], "ns a bead and step");
                snprintf(name, sizeof name, "bed.n%d.cost_growth", beds[i].asked);
                bench_result_short(name, growth, "ratio to 2e4");
                if (page) fprintf(page, "| %d | %.2f | %.1f | %.2f |", s.count, touches, ns[1], growth);
                continue;
            }
            snprintf(name, sizeof name, "bed.n%d.%s%d.speedup", beds[i].asked, runs[r].how->name, runs[r].workers);
            speedup = bench_median_ratio(runs[1].seconds, runs[r].seconds, turns);
            bench_result_short(name, speedup, processors && runs[r].workers > processors ? "(more workers than processors)" : "");
            if (speedup > tau) {
                tau = speedup;
                snprintf(fastest, sizeof fastest, "%.2f | %d %ss", tau, runs[r].workers, runs[r].how->worker);
            }
        }
        if (page && steps) fprintf(page, " %s |\n", *fastest ? fastest : "|");
        if (steps) number[done++] = s.count;
        for (r = 0; r < count; r++) runs[r].how->stop(runs[r].self);
        bench_scene_free(&s);
    }
    bench_scene_free(&bed);
    if (done < 2) return;
    memset(&f, 0, sizeof f);
    f.title = "Cost of a bead and step against the number of beads";
    f.x_label = "beads";
    f.y_label = "ns a bead and step";
    f.log_x = 1;
    f.y0 = 0;
    for (k = 0; k < lines; k++)
        for (i = 0; i < done; i++) f.y1 = fmax(f.y1, 1.1*cost[k][i]);
    for (k = 0; k < lines; k++) study_curve(&f, legend[k], STUDY_LINE, done, number, cost[k]);
    study_figure_write(&f, "scaling.svg");
}

/* ---- pictures of the speedups ---- */

enum { SCENES, TABLES, SHAPES, PICTURES };
/* The picture that has a scene. */
static int picture_of(const char *scene) {
    int i;
    for (i = 0; i < HEAPS; i++) if (!strcmp(heaps[i].name, scene)) return SHAPES;
    return !strncmp(scene, "discs", 5) ? TABLES : SCENES;
}
/* TABLES: the discs beside what [ALK07] printed. */
static void speedups_draw(int picture) {
    const int tables = picture == TABLES;
    static double x[STUDY_CURVES][64], y[STUDY_CURVES][64], ideal[2][2] = {{1, 25}, {1, 25}};
    static char names[STUDY_CURVES][40];
    study_figure f;
    size_t k;
    int i, n, w;
    memset(&f, 0, sizeof f);
    f.title = tables ? "Speedup: discs here, and Tables 3.2 to 3.4 of [ALK07] (dashed)" : "Speedup";
    f.x_label = tables ? "workers (here of one machine, there of several)" : "workers";
    f.y_label = "speedup";
    f.log_x = f.log_y = 1;
    f.x1 = tables ? log10(30) : 1;
    f.y0 = log10(0.3);
    f.y1 = tables ? log10(300) : 1;
    study_curve(&f, "as many times faster", STUDY_FAINT, 2, ideal[0], ideal[1]);
    for (w = 0; w < WAYS; w++) {
        while (w && f.curve_count%10 != 1) study_curve(&f, 0, STUDY_LINE, 0, 0, 0); /* so that colours agree */
        for (i = 0; i < point_count && f.curve_count + 4 < STUDY_CURVES;) {
            double *px = x[f.curve_count], *py = y[f.curve_count];
            const point *p = &points[i];
            px[0] = py[0] = 1;
            for (n = 1; i < point_count && n < 64 && !strcmp(points[i].scene, p->scene) && points[i].how == p->how; i++, n++) {
                px[n] = points[i].workers;
                py[n] = points[i].speedup;
            }
            if (p->how != &ways[w] || picture_of(p->scene) != picture) continue;
            snprintf(names[f.curve_count], sizeof *names, "%s, %ss", p->scene, p->how->worker);
            study_curve(&f, names[f.curve_count], w ? STUDY_DOTS : STUDY_LINE, n, px, py);
        }
    }
    if (f.curve_count < 2) return;
    while (tables && f.curve_count%10 != 1) study_curve(&f, 0, STUDY_LINE, 0, 0, 0);
    for (k = 0; k < sizeof printed_serial/sizeof *printed_serial && tables; k++) {
        double *px = x[f.curve_count], *py = y[f.curve_count];
        px[0] = py[0] = 1;
        for (i = 0, n = 1; i < PRINTED; i++)
            if (printed[i].count == printed_serial[k].count && printed[i].several > 0) {
                px[n] = printed[i].workers;
                py[n++] = printed[i].several;
            }
        snprintf(names[f.curve_count], sizeof *names, "[ALK07], %d", printed_serial[k].count);
        study_curve(&f, names[f.curve_count], STUDY_DASHED, n, px, py);
    }
    study_figure_write(&f, tables ? "speedup_tables.svg" : picture == SHAPES ? "speedup_shapes.svg" : "speedup.svg");
}

/* ---- the model of a cluster ---- */

/* Slabs, as in [ALK07] 3.5, with messages as dem.h's slabs send them: measured on the bed of 1e5 beads in two slabs, as
   grains of a halo for a border of one square diameter, and bytes a grain of the halo and step, there and back,
   with the share of renewed lists and migrants. Per step a rank exchanges up and down at each of its borders, and
   all agree on one maximum. Assumed, not measured: the networks, and copies into and out of messages. */
typedef struct network { const char *name, *about; double latency, bandwidth; } network; /* s, byte/s */
static const network networks[] = {
    {"ethernet", "10 GbE, TCP", 25e-6, 1.1e9}, {"infiniband", "InfiniBand HDR", 1.5e-6, 12e9}};
#define MODEL_COPY 5e9           /* byte/s */
#define MODEL_PACKED 1.146       /* grains a cubic diameter, at packing 0.6 */
static double model_layer, model_bytes; /* grains a square diameter of border; bytes a grain of the halo and step */

static double model_side(double grains) { return pow(grains/MODEL_PACKED, 1.0/3); } /* diameters, of a cube */
static double model_halo(double grains) { const double S = model_side(grains); return model_layer*S*S; }
/* Seconds a step on P ranks; *share: of them spent on messages. */
static double model_step(double grains, double P, double grain_cost, const network *net, double *share) {
    const double h = model_halo(grains), work = grains/P*grain_cost;
    const double border = 2*net->latency + h*model_bytes*(1/net->bandwidth + 2/MODEL_COPY);
    const double talk = P > 1 ? (P > 2 ? 2 : 1)*border + 2*ceil(log(P)/log(2) - 1e-9)*net->latency : 0;
    if (share) *share = talk/(work + talk);
    return work + talk;
}
/* Messages, and ns a bead and step on one core, of the bed of 1e5 beads; 0 when something broke. */
static double model_measure(void) {
    bench_scene bed = bench_scene_read(data_folder, "bed"), s = bed_tile(&bed, 5, 1);
    const subject of = scene_subject("bed", &s, 40);
    run serial, slabs;
    double ns = cost_asked;
    int steps, turns;
    if (!(ns > 0) && run_start(&of, &serial, &ways[0], 1)) {
        steps = loop_steps(&of, &serial, 10);
        turns = steps ? runs_turn(&of, &serial, 1, steps) : 0;
        if (turns) ns = 1e9*bench_median(serial.seconds, turns)/((double)steps*s.count);
        serial.how->stop(serial.self);
    }
    if (run_start(&of, &slabs, &ways[1], 2)) {
        const double length = s.side[0]/(2*s.radius), border = s.count/(MODEL_PACKED*length); /* diameters, their square */
        if (run_steps(&of, &slabs, short_form ? 60 : 200) >= 0) {
            const sent messages = slabs_sent((const dealt *)slabs.self);
            tell_sent(2, &messages);
            model_layer = messages.halo/border;
            model_bytes = messages.halo > 0 ? messages.bytes/messages.halo : 0;
        }
        slabs.how->stop(slabs.self);
    }
    bench_scene_free(&bed);
    bench_scene_free(&s);
    return model_layer > 0 ? ns : 0;
}
static void model_part(void) {
    static const double sizes[3] = {1e5, 1e6, 1e7};
    static double x[6][16], y[6][16];
    static char names[6][48];
    const double ns = model_measure();
    double ideal[2][2] = {{1, 256}, {1, 256}};
    study_figure f;
    int i, k, n, P;
    char name[64];
    bench_result_short("model.grain_cost", ns, cost_asked > 0 ? "ns (given)" : "ns (measured: bed, 1e5 beads, one thread)");
    if (!(ns > 0)) return;
    bench_result_short("model.halo", model_layer, "grains a square diameter of a border (measured)");
    bench_result_short("model.bytes", model_bytes, "a grain of the halo and step, there and back (measured)");
    memset(&f, 0, sizeof f);
    f.title = "A model, not a measurement: speedup in slices";
    f.x_label = "ranks";
    f.y_label = "speedup";
    f.log_x = f.log_y = 1;
    study_curve(&f, "as many times faster", STUDY_FAINT, 2, ideal[0], ideal[1]);
    if (page) fprintf(page, "Inputs: `c` = %.1f ns per grain and step (%s); `a` = %.2f grains of the halo per square diameter of "
                      "border and `b` = %.0f byte per grain of the halo and step, both ways (measured on the bed of 1e5 beads in two "
                      "slabs).\n\n| grains | network | grains in the halo | kB per border and step | speedup on 2 ranks | 8 ranks | "
                      "32 ranks | 64 ranks |\n|---|---|---|---|---|---|---|---|\n",
                      ns, cost_asked > 0 ? "given" : "measured on one thread", model_layer, model_bytes);
    csv = bench_table_open("model.csv", "grains,network,halo_grains,kB_per_border_and_step,ranks,step_ms,speedup,efficiency,"
                           "messages_percent");
    for (i = 0; i < 3; i++)
        for (k = 0; k < 2; k++) {
            const double serial = model_step(sizes[i], 1, 1e-9*ns, &networks[k], 0);
            double best = 0, *px = x[2*i + k], *py = y[2*i + k];
            int shown = 0;
            if (page) fprintf(page, "| %.0e | %s | %.0f | %.0f |", sizes[i], networks[k].about, model_halo(sizes[i]),
                              1e-3*model_bytes*model_halo(sizes[i]));
            for (P = 1, n = 0; P <= 256 && P <= model_side(sizes[i])/2; P *= 2, n++) { /* no slice thinner than two diameters */
                double share, t = model_step(sizes[i], P, 1e-9*ns, &networks[k], &share);
                px[n] = P;
                py[n] = serial/t;
                best = fmax(best, py[n]);
                snprintf(name, sizeof name, "model.n%.0f.%s.ranks%d.speedup", sizes[i], networks[k].name, P);
                bench_result_short(name, py[n], "");
                if (csv)
                    fprintf(csv, "%.0e,\"%s\",%.0f,%.0f,%d,%.3g,%.1f,%.2f,%.0f\n", sizes[i], networks[k].about, model_halo(sizes[i]),
                            1e-3*model_bytes*model_halo(sizes[i]), P, 1e3*t, py[n], py[n]/P, 100*share);
                if (page && (P == 2 || P == 8 || P == 32 || P == 64)) { fprintf(page, " %.1f |", py[n]); shown++; }
            }
            for (; page && shown < 4; shown++) fprintf(page, " |");
            if (page) fprintf(page, "\n");
            snprintf(names[2*i + k], sizeof *names, "%.0e, %s", sizes[i], networks[k].about);
            study_curve(&f, names[2*i + k], k ? STUDY_DASHED : STUDY_LINE, n, px, py);
        }
    study_close(csv, "model.csv");
    csv = 0;
    study_figure_write(&f, "model.svg");
}

/* ---- all of it ---- */

static int wanted(const char *name) { return !strcmp(part, "all") || !strcmp(part, name); }

int main(int argc, char **argv) {
    static const study_option choices[] = {
        {"part", STUDY_CHOICE, &part, 0, 0, "all|bed|drum|gas|mill|tables|shapes|searches|scaling", "what to measure"},
        {"threads", STUDY_INT, &most_workers, 1, 64, "", "and slabs, the most: of 2, 3, 4, 8"},
        {"short", STUDY_FLAG, &short_form, 0, 0, "", "a first look: shorter loops, fewer turns, no million"},
        {"full", STUDY_FLAG, &full_form, 0, 0, "", "long loops, all threads, the whole 4 s of the tank: an hour"},
        {"span", STUDY_REAL, &span_asked, 1e-4, 100, "s", "simulated, of each search; 0: .02"},
        {"settle", STUDY_REAL, &settle_asked, 0, 10, "turns", "of the mill before it is timed; kept for next time"},
        {"model", STUDY_FLAG, &model_only, 0, 0, "", "what a cluster might do, and nothing else"},
        {"grain-cost", STUDY_REAL, &cost_asked, 0, 1e6, "ns", "model: a grain and step; 0: measured"},
        {"data", STUDY_TEXT, &data_folder, 0, 0, "", "where the start states are"},
        {"out", STUDY_TEXT, &out_folder, 0, 0, "", "folder of results"},
    };
    const double load = bench_load();
    int k;
    study_options(argc, argv, "What threads and slabs gain, how cost grows with the number of grains, how the searches compare.",
                  choices, (int)(sizeof choices/sizeof *choices));
    if (short_form && full_form) { study_fail("--short or --full, not both"); return 2; }
    study_begin(*out_folder ? out_folder : model_only ? "build/out/model" : "build/out/parallel");
    processors = bench_machine();
    page = bench_page_open();
    if (page) bench_page_machine(page, load);
    if (model_only) model_part();
    else {
        if (processors > 1) processors_part();
        csv = bench_table_open("speedups.csv", "scene,grains,on,workers,more_workers_than_processors,M_particle_steps_per_s,speedup,"
                               "efficiency,cost,overhead,published_on_one_machine,published_on_several_machines");
        if (wanted("bed")) scene_part("bed");
        if (wanted("drum")) scene_part("drum");
        if (wanted("gas")) scene_part("gas");
        if (wanted("mill")) mill_part();
        if (wanted("tables")) tables_part();
        if (wanted("shapes")) shapes_part();
        study_close(csv, "speedups.csv");
        csv = 0;
        page_speedups();
        tell_page_sent();
        for (k = 0; k < PICTURES; k++) speedups_draw(k);
        if (wanted("searches")) searches_part();
        if (wanted("scaling")) scaling_part();
    }
    study_close(page, "page.md");
    return study_end();
}
