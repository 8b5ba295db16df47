/* sifting.h - curves over time of a machine with decks one above the other: what lies on each deck, what falls through the
   sieve above it, what leaves it, and how well it sorts. MIT licence. Include it after dem.h, sorting.h and study.h.

       sifting s;
       sifting_begin(&s, world, frame, spacing, outlets, wanted, decks, feed, seconds);
       while (...) {
           if (sifting_due(&s)) sifting_take(&s);
           ... dem_world_step ...
       }
       sifting_end(&s);                            // flows from masses; then s.value[quantity][deck][sample]
       sifting_add(&sum, &s);                      // means and spreads over several runs
       sifting_write(&sum, "deck");                // deck.csv, and an SVG file for each quantity

   Deck 0 is the lowest. The index `decks` of a curve is the whole machine. Undersize of a deck is the mass on it of grains
   smaller than those wanted there, which should fall further. Oversize is the rest. Flows are means over SIFTING_WINDOW
   samples. Every grain enters at the highest deck, so

       what has reached deck k = what is on it, what has left it, and what has reached deck k - 1. */
#ifndef SIFTING_H
#define SIFTING_H

enum { SIFTING_DECKS = 5, SIFTING_SAMPLES = 200, SIFTING_WINDOW = 10 };
enum sifting_quantity {
    SIFTING_ON, SIFTING_UNDER, SIFTING_OVER, SIFTING_THROUGH, SIFTING_OUT, SIFTING_SORTED, SIFTING_GANGUE,
    SIFTING_EFFICIENCY, SIFTING_EFFICIENCY_MASS, SIFTING_GANGUE_MASS, SIFTING_QUANTITIES
};
static const struct { const char *name, *title, *label; } sifting_names[SIFTING_QUANTITIES] = {
    {"on", "Mass on each deck", "mass [kg]"},
    {"undersize", "Undersize on each deck", "mass [kg]"},
    {"oversize", "Oversize on each deck", "mass [kg]"},
    {"through", "Flow onto each deck: through the sieve above it, or fed", "flow [kg/s]"},
    {"out", "Flow over the rim of each deck", "flow [kg/s]"},
    {"sorted", "Sorted balls that left each deck", "balls"},
    {"gangue", "Gangue that left each deck", "balls"},
    {"efficiency", "Sorting efficiency", "efficiency by number [%]"},
    {"efficiency_mass", "Sorting efficiency by mass", "efficiency by mass [%]"},
    {"gangue_mass", "Gangue", "gangue, share of mass that left [%]"},
};

typedef struct sifting {
    dem_world *world;
    dem_wall frame;                /* the lowest deck, at z = 0 of its frame */
    dem_feed feed;
    const dem_outlet *outlet;
    double spacing, interval, wanted[SIFTING_DECKS];   /* m; s; m, smallest radius wanted on a deck */
    int decks, samples, runs;      /* runs: of which this is the mean */
    double time[SIFTING_SAMPLES];
    double value[SIFTING_QUANTITIES][SIFTING_DECKS + 1][SIFTING_SAMPLES];
    double square[SIFTING_QUANTITIES][SIFTING_DECKS + 1][SIFTING_SAMPLES];   /* sums over runs, of squares */
    double fed[SIFTING_SAMPLES], present[SIFTING_SAMPLES], left[SIFTING_SAMPLES];   /* grains */
} sifting;

STUDY_FN void sifting_begin(sifting *s, dem_world *world, dem_wall frame, double spacing, const dem_outlet *outlets,
                            const double *wanted, int decks, dem_feed feed, double seconds) {
    int k;
    memset(s, 0, sizeof *s);
    s->world = world; s->frame = frame; s->feed = feed; s->outlet = outlets;
    s->spacing = spacing; s->decks = decks; s->interval = seconds/(SIFTING_SAMPLES - 1);
    for (k = 0; k < decks; k++) s->wanted[k] = wanted[k];
}
/* Returns the time (s) of the next sample. */
STUDY_FN double sifting_next(const sifting *s) { return s->samples*s->interval; }

/* Returns the deck on which a point lies. */
STUDY_FN int sifting_deck(const sifting *s, const dem_pose *pose, const dem_real *x) {
    const dem_real *R = pose->rotation;
    const double z = (double)(R[2]*(x[0] - pose->position.x) + R[5]*(x[1] - pose->position.y) +
                              R[8]*(x[2] - pose->position.z));
    const int deck = (int)floor(z/s->spacing);
    return deck < 0 ? 0 : deck < s->decks ? deck : s->decks - 1;
}
/* Takes a sample. Flows are kept as sums since the start; sifting_end makes rates of them. */
STUDY_FN void sifting_take(sifting *s) {
    const dem_bodies b = dem_bodies_get(s->world);
    const int i = s->samples, all = s->decks;
    double reached = 0;
    dem_feed_state fed;
    dem_pose pose;
    sorting sorted;
    int k, n;
    if (i == SIFTING_SAMPLES || sorting_get(s->world, s->outlet, s->decks, &sorted) != DEM_OK ||
        dem_wall_pose_get(s->world, s->frame, &pose) != DEM_OK || dem_feed_get(s->world, s->feed, &fed) != DEM_OK) return;
    s->time[i] = dem_world_time_get(s->world);
    s->fed[i] = (double)fed.total;
    for (n = 0; n < b.count; n++) {
        const int deck = sifting_deck(s, &pose, b.positions + 4*n);
        const int small = (double)b.positions[4*n + 3] < s->wanted[deck];
        s->value[SIFTING_ON][deck][i] += (double)b.masses[n];
        s->value[small ? SIFTING_UNDER : SIFTING_OVER][deck][i] += (double)b.masses[n];
    }
    for (k = 0; k < s->decks; k++) {
        dem_outlet_state out;
        if (dem_outlet_get(s->world, s->outlet[k], &out) != DEM_OK) return;
        reached += s->value[SIFTING_ON][k][i] + out.total_mass;
        s->value[SIFTING_THROUGH][k][i] = reached;
        s->value[SIFTING_OUT][k][i] = out.total_mass;
        s->value[SIFTING_SORTED][k][i] = (double)out.sorted;
        s->value[SIFTING_GANGUE][k][i] = (double)out.gangue;
        s->value[SIFTING_EFFICIENCY][k][i] = out.total ? 100*(double)out.sorted/(double)out.total : 0;
        s->value[SIFTING_EFFICIENCY_MASS][k][i] = out.total ? 100*out.sorted_mass/out.total_mass : 0;
        s->value[SIFTING_GANGUE_MASS][k][i] = out.total ? 100*out.gangue_mass/out.total_mass : 0;
        for (n = SIFTING_ON; n <= SIFTING_GANGUE; n++)
            if (n != SIFTING_THROUGH) s->value[n][all][i] += s->value[n][k][i];
        s->left[i] += (double)out.total;
    }
    s->value[SIFTING_THROUGH][all][i] = reached;
    s->value[SIFTING_EFFICIENCY][all][i] = 100*sorted.efficiency_number;
    s->value[SIFTING_EFFICIENCY_MASS][all][i] = 100*sorted.efficiency_mass;
    s->value[SIFTING_GANGUE_MASS][all][i] = 100*sorted.gangue_mass;
    s->present[i] = b.count;
    s->samples++;
}
STUDY_FN void sifting_end(sifting *s) {
    double sum[SIFTING_SAMPLES];
    int k, i, q;
    for (q = SIFTING_THROUGH; q <= SIFTING_OUT; q++)
        for (k = 0; k <= s->decks; k++) {
            memcpy(sum, s->value[q][k], sizeof sum);
            for (i = 0; i < s->samples; i++) {
                const int a = i < SIFTING_WINDOW/2 ? 0 : i - SIFTING_WINDOW/2;
                const int b = i + SIFTING_WINDOW/2 < s->samples ? i + SIFTING_WINDOW/2 : s->samples - 1;
                s->value[q][k][i] = b > a ? (sum[b] - sum[a])/(s->time[b] - s->time[a]) : 0;
            }
        }
}

/* Returns the time (s) after which a curve stays within `within` of its mean over the last tenth of the time. */
STUDY_FN double sifting_steady(const sifting *s, int quantity, int deck, double within) {
    const double *y = s->value[quantity][deck];
    const int late = s->samples - s->samples/10;
    double mean = 0;
    int i;
    for (i = late; i < s->samples; i++) mean += y[i]/(s->samples - late);
    for (i = s->samples; i > 0 && fabs(y[i - 1] - mean) <= within;) i--;
    return i < s->samples ? s->time[i] : s->samples ? s->time[s->samples - 1] : 0;
}

/* Adds a run to the sum of several runs of equal length; `sum` is zero before the first. */
STUDY_FN void sifting_add(sifting *sum, const sifting *s) {
    int q, k, i;
    if (!sum->runs) { sum->samples = s->samples; sum->decks = s->decks; memcpy(sum->time, s->time, sizeof s->time); }
    if (s->samples < sum->samples) sum->samples = s->samples;
    sum->runs++;
    for (q = 0; q < SIFTING_QUANTITIES; q++)
        for (k = 0; k <= s->decks; k++)
            for (i = 0; i < sum->samples; i++) {
                const double y = s->value[q][k][i], before = sum->value[q][k][i];
                sum->value[q][k][i] += (y - before)/sum->runs;
                sum->square[q][k][i] += (y - before)*(y - sum->value[q][k][i]);
            }
    for (i = 0; i < sum->samples; i++) {
        sum->fed[i] += (s->fed[i] - sum->fed[i])/sum->runs;
        sum->present[i] += (s->present[i] - sum->present[i])/sum->runs;
        sum->left[i] += (s->left[i] - sum->left[i])/sum->runs;
    }
}
/* Returns the standard deviation of one run. */
STUDY_FN double sifting_spread(const sifting *s, int quantity, int deck, int sample) {
    return s->runs > 1 ? sqrt(s->square[quantity][deck][sample]/(s->runs - 1)) : 0;
}

/* Adds the rows of the curves to a CSV file that the caller has opened; a name comes first in each row. */
STUDY_FN void sifting_rows(const sifting *s, FILE *file, const char *name) {
    int q, k, i;
    for (k = 0; k <= s->decks; k++)
        for (i = 0; i < s->samples; i++) {
            if (k < s->decks) fprintf(file, "%s,%d,%.6g", name, k + 1, s->time[i]);
            else fprintf(file, "%s,machine,%.6g", name, s->time[i]);
            for (q = 0; q < SIFTING_QUANTITIES; q++) fprintf(file, ",%.6g", s->value[q][k][i]);
            for (q = 0; q < SIFTING_QUANTITIES; q++) fprintf(file, ",%.3g", sifting_spread(s, q, k, i));
            fputc('\n', file);
        }
}
STUDY_FN void sifting_heading(FILE *file) {
    int q;
    fputs("run,deck,time", file);
    for (q = 0; q < SIFTING_QUANTITIES; q++) fprintf(file, ",%s", sifting_names[q].name);
    for (q = 0; q < SIFTING_QUANTITIES; q++) fprintf(file, ",%s_spread", sifting_names[q].name);
    fputc('\n', file);
}
/* Draws a quantity over time into NAME_QUANTITY.svg: a curve for each deck, and for the machine where the sum or the mean
   over decks is of the same size. */
STUDY_FN void sifting_draw(const sifting *s, int quantity, const char *name) {
    static const char *const deck_names[SIFTING_DECKS] = {"deck 1, lowest", "deck 2", "deck 3", "deck 4", "deck 5"};
    const int mean = quantity >= SIFTING_EFFICIENCY;
    char file[96];
    study_figure f;
    int k;
    memset(&f, 0, sizeof f);
    f.title = sifting_names[quantity].title;
    f.x_label = "time [s]";
    f.y_label = sifting_names[quantity].label;
    for (k = 0; k < s->decks; k++)
        study_curve(&f, deck_names[k], mean ? STUDY_DASHED : STUDY_LINE, s->samples, s->time, s->value[quantity][k]);
    if (mean) study_curve(&f, "machine", STUDY_LINE, s->samples, s->time, s->value[quantity][s->decks]);
    snprintf(file, sizeof file, "%s%s%s.svg", name, *name ? "_" : "", sifting_names[quantity].name);
    study_figure_write(&f, file);
}
STUDY_FN void sifting_write(const sifting *s, const char *name) {
    char file[96];
    FILE *csv;
    int q;
    snprintf(file, sizeof file, "%s.csv", name);
    csv = study_open(file);
    if (csv) { sifting_heading(csv); sifting_rows(s, csv, name); study_close(csv, file); }
    for (q = 0; q < SIFTING_QUANTITIES; q++) sifting_draw(s, q, name);
}
#endif
