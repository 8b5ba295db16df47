/* accuracy_variants.h - what another build of the same program found: single precision, all bodies in one domain.
   MIT licence. Needs all that bench/accuracy.c includes before it.

   A build that has BENCH_VARIANT defined writes lines "diagram,setting,cost,unit,value,bar" to points.csv: cost in
   units of its own library setting, unit in seconds, so that the ordinary build can convert it. */
#ifndef ACCURACY_VARIANTS_H
#define ACCURACY_VARIANTS_H

static const char *data_folder = "bench/data";
static FILE *variant_file;          /* being written; null in the ordinary build                             */

static const char *variant_name(void) {
#ifdef BENCH_VARIANT
    return BENCH_VARIANT;
#else
    return 0;
#endif
}
static const char *variant_folder(const char *name) {
    static char text[128];
    snprintf(text, sizeof text, "build/out/accuracy_%s", name);
    return text;
}
static void variant_begin(void) {
    if (variant_name()) variant_file = study_open("points.csv");
}
static void variant_end(void) {
    if (variant_file) study_close(variant_file, "points.csv");
}
static void variant_note(const char *diagram, const char *label, double cost, double unit, double value, double bar) {
    if (variant_file) fprintf(variant_file, "%s,%s,%.6g,%.6g,%.9g,%.6g\n", diagram, label, cost, unit, value, bar);
}
typedef struct note { char label[32]; double cost, unit, value, bar; } note;
/* The notes another build left about a diagram; 0: none. */
static int variant_notes(const char *name, const char *diagram, note *notes, int most) {
    char path[200], line[256], of[64];
    int count = 0;
    FILE *file;
    snprintf(path, sizeof path, "%s/points.csv", variant_folder(name));
    file = variant_name() ? 0 : fopen(path, "r");
    while (file && count < most && fgets(line, sizeof line, file)) {
        note *n = &notes[count];
        if (sscanf(line, "%63[^,],%31[^,],%lf,%lf,%lf,%lf", of, n->label, &n->cost, &n->unit, &n->value,
                   &n->bar) == 6 && !strcmp(of, diagram)) count++;
    }
    if (file) fclose(file);
    return count;
}
/* Adds points of single precision. unit: s, of this build; values are errors, or are compared with a reference. */
static void variant_points(points *p, double unit, double reference, double reference_bar) {
    note notes[32];
    const int count = variant_notes("single", p->name, notes, 32);
    const double scale = fabs(reference) > 0 ? fabs(reference) : 1;
    int i;
    for (i = 0; i < count; i++)
        points_add(p, "single precision", notes[i].label, notes[i].cost*notes[i].unit/unit,
                   (notes[i].value - reference)/scale, notes[i].bar > 0 ? hypot(notes[i].bar, reference_bar)/scale : 0);
    if (count) return;
    if (!variant_name()) printf("# %s: no points in single precision; build/accuracy_single makes them\n", p->name);
}
/* Of a scene: notes those with the library's own choices but for the step (series as the second's), or adds them. */
static void variant_scene(points *p, const choice *c, int count, int seeds, const outcome *out, int what, int compare) {
    double units[SCENE_SEEDS] = {0}, bar, reference_bar = 0, unit, reference = 0;
    int i;
    for (i = 0; i < seeds; i++) units[i] = out[SCENE_SEEDS + i].seconds;
    unit = bench_median(units, seeds);
    for (i = 1; i < count && variant_file; i++) {
        const double mean = scene_mean(out + i*SCENE_SEEDS, seeds, what, &bar);
        if (!strcmp(c[i].series, c[1].series))
            variant_note(p->name, c[i].label, scene_cost(out + i*SCENE_SEEDS, out + SCENE_SEEDS, seeds), unit, mean,
                         compare ? bar : 0);
    }
    if (compare) reference = scene_mean(out, 2*seeds, what, &reference_bar);
    if (!variant_name()) variant_points(p, unit, reference, reference_bar);
}
#endif /* ACCURACY_VARIANTS_H */
