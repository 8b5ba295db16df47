/* measure.h - shared by the benches: clocks, medians, output of results, a description of the machine. MIT licence.

   Needs examples/study.h before it. BENCH_FLAGS is the compiler's flags, from the Makefile.

       bench_machine();                              // processor, compiler, flags, load: the first lines
       bench_result_rate("rate", 1.2e7);             // rate = 12.00e6 particle-steps/s
       bench_result_short("speedup", 1.8342, "");    // speedup = 1.83
       file = bench_data_open("effects.csv", "build/bench --scene effects", "effect,time of a step [without = 1]");
*/
#ifndef BENCH_MEASURE_H
#define BENCH_MEASURE_H

#ifndef BENCH_FLAGS
#define BENCH_FLAGS "unknown"
#endif
#if defined(__clang__)
#define BENCH_COMPILER "clang " __clang_version__
#elif defined(__GNUC__)
#define BENCH_COMPILER "gcc " __VERSION__
#else
#define BENCH_COMPILER "unknown"
#endif

enum { BENCH_MOST_LOOPS = 99 };

/* ---- of several turns ---- */

STUDY_FN int bench_compare(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}
STUDY_FN double bench_median(const double *values, int count) {
    double sorted[BENCH_MOST_LOOPS];
    memcpy(sorted, values, (size_t)count*sizeof *values);
    qsort(sorted, (size_t)count, sizeof *sorted, bench_compare);
    return count & 1 ? sorted[count/2] : (sorted[count/2 - 1] + sorted[count/2])/2;
}
/* Of a[i]/b[i], of the same turn: what disturbs a turn disturbs both. */
STUDY_FN double bench_median_ratio(const double *a, const double *b, int count) {
    double ratio[BENCH_MOST_LOOPS];
    int i;
    for (i = 0; i < count; i++) ratio[i] = a[i]/b[i];
    return bench_median(ratio, count);
}
STUDY_FN double bench_spread(const double *values, int count) { /* half the range over the median, % */
    double lo = values[0], hi = values[0];
    int i;
    for (i = 1; i < count; i++) { lo = fmin(lo, values[i]); hi = fmax(hi, values[i]); }
    return 50*(hi - lo)/bench_median(values, count);
}

/* ---- output of results ---- */

STUDY_FN void bench_result_rate(const char *name, double rate) { /* with the exponent one reads rates in */
    char text[64];
    snprintf(text, sizeof text, "%.2fe6", 1e-6*rate);
    study_result_text(name, text, "particle-steps/s");
}
STUDY_FN void bench_result_short(const char *name, double value, const char *unit) { /* three digits    */
    char text[64];
    snprintf(text, sizeof text, fabs(value) < 1000 ? "%.3g" : "%.0f", value);
    study_result_text(name, text, unit);
}
/* A page in markdown beside the results. bench/pages.sh puts it into docs. */
STUDY_FN FILE *bench_page_open(void) { return study_open("page.md"); }
/* A table beside the results, NAME.csv, with its line of headings. bench/pages.sh puts it into docs/data. */
STUDY_FN FILE *bench_table_open(const char *name, const char *heading) {
    FILE *file = study_open(name);
    if (file) fprintf(file, "%s\n", heading);
    return file;
}

/* ---- the machine ---- */

/* How many processors, 0 if not known, and their name. "AMD EPYC" is sold in every generation: x86 tells them apart by
   family and model. */
STUDY_FN int bench_processors(char *name, size_t room) {
    char line[512];
    int count = 0, family = 0, model = 0;
    FILE *file = fopen("/proc/cpuinfo", "r");
    snprintf(name, room, "unknown processor");
    while (file && fgets(line, sizeof line, file)) {
        const char *colon = strchr(line, ':');
        if (!strncmp(line, "processor", 9)) count++;
        if (colon && !strncmp(line, "cpu family", 10)) family = atoi(colon + 1);
        if (colon && !strncmp(line, "model\t", 6)) model = atoi(colon + 1);
        if (strncmp(line, "model name", 10) || !colon) continue;
        snprintf(name, room, "%.200s", colon + 2);
        name[strcspn(name, "\n")] = 0;
    }
    if (family) snprintf(name + strlen(name), room - strlen(name), " (family %d, model %d)", family, model);
    if (file) fclose(file);
    return count;
}
/* Processors that others keep busy, in the second that this takes; 0: not known. The load of the last minute would be that
   of the bench before, where several run one after the other. */
STUDY_FN double bench_load(void) {
    char name[256];
    double busy[2] = {0, 0}, all[2] = {0, 0}, own;
    const clock_t begun = clock();
    const double first = study_clock();
    int k, e;
    for (k = 0; k < 2; k++) {
        FILE *file = fopen("/proc/stat", "r");
        double part[8] = {0, 0, 0, 0, 0, 0, 0, 0};      /* user nice system idle iowait irq softirq steal */
        if (!file) return 0;
        if (fscanf(file, "cpu %lf %lf %lf %lf %lf %lf %lf %lf", part, part + 1, part + 2, part + 3, part + 4, part + 5, part + 6,
                   part + 7) != 8) part[3] = -1;
        fclose(file);
        if (part[3] < 0) return 0;
        for (e = 0; e < 8; e++) {
            all[k] += part[e];
            busy[k] += e == 3 || e == 4 ? 0 : part[e];
        }
        while (!k && study_clock() - first < 1) continue;
    }
    own = (double)(clock() - begun)/CLOCKS_PER_SEC;
    return all[1] > all[0] ? (busy[1] - busy[0])/(all[1] - all[0])*bench_processors(name, sizeof name) - own : 0;
}
/* The load is asked at the beginning only: later it is our own. */
STUDY_FN int bench_machine(void) { /* answers how many processors                                      */
    char line[512], name[256];
    const double load = bench_load();
    const int count = bench_processors(name, sizeof name);
    if (load > 0.5) printf("# load %.1f: other work runs here, which is worst for what runs on threads\n", load);
    snprintf(line, sizeof line, "%s, %d logical processors", name, count);
    study_result_text("machine", line, "");
    study_result_text("compiler", BENCH_COMPILER, "");
    study_result_text("flags", BENCH_FLAGS, "");
    return count;
}
/* The same as one line of a page. On a busy machine the page begins with a mark, and bench/pages.sh does not copy it. */
STUDY_FN void bench_page_machine(FILE *page, double load) {
    char name[256];
    const int count = bench_processors(name, sizeof name);
    if (load > 0.5) fprintf(page, "<!-- busy: other work kept %.1f processors -->\n", load);
    fprintf(page, "%s, %d logical processors; %s; `%s`.\n\n", name, count, BENCH_COMPILER, BENCH_FLAGS);
}
/* Opens a table of numbers beside the results, for docs/data: a comment with the command and the machine, then the header
   line. Close it with study_close. */
STUDY_FN FILE *bench_data_open(const char *file_name, const char *command, const char *header) {
    char name[256];
    const int count = bench_processors(name, sizeof name);
    FILE *file = study_open(file_name);
    if (file) fprintf(file, "# %s; %s, %d logical processors; %s; %s\n%s\n", command, name, count, BENCH_COMPILER,
                      BENCH_FLAGS, header);
    return file;
}

#endif /* BENCH_MEASURE_H */
