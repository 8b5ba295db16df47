/* study.h - functions that the studies and benches share: options, progress, results, CSV, pictures
   (SVG). MIT licence. It needs only libc and libm, and dem.h does not need it. Include it in one file of
   a program.

       static double speed = 0.7;                            // the present value is the default of the option
       static const study_option table[] = {
           {"speed", STUDY_REAL, &speed, 0.01, 3, "of critical", "speed of the mill"},
       };
       study_options(argc, argv, "what it does", table, 1);  // --help; exit code 2 on a mistake
       study_begin("build/results");                         // makes folder and summary.txt
       study_progress("mill", 0.1, particle_steps);          // as often as you like; prints on stderr
       study_result("torque_mean", 0.031, "N m");            // prints on stdout and into summary.txt
       return study_end();                                   // 0, or 1 if something failed
*/
#ifndef STUDY_H
#define STUDY_H

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#if defined(__unix__) || defined(__APPLE__)
#include <sys/stat.h>
#include <sys/time.h>
#include <unistd.h>
#define STUDY_POSIX 1
#define study_terminal() isatty(2)
#else
#define study_terminal() 0
#endif
#if defined(__GNUC__)
#define STUDY_FN static __attribute__((unused))
#else
#define STUDY_FN static
#endif

typedef struct study_state {
    const char *program;          /* name in messages */
    char root[400], folder[480];  /* results of the whole study; of the present part of it */
    char prefix[64];              /* put before the names of results */
    int files, failures;          /* written; things that went wrong */
    int quiet;                    /* 1: writes and prints failures only, because another process does the rest */
    double begun, shown;          /* s, wall clock: of this progress line */
    int tenths, open;             /* tenths printed; 1: a line is open on the terminal */
    char told[64];                /* task that the line reports */
    char replay[1024];            /* file of the replay, printed by study_end; "": none */
} study_state;
static study_state study;

/* ---- small things ---- */

STUDY_FN double study_clock(void) { /* s, wall clock */
#ifdef STUDY_POSIX
    struct timeval now;
    gettimeofday(&now, 0);
    return (double)now.tv_sec + 1e-6*(double)now.tv_usec;
#else
    return (double)time(0);
#endif
}

/* Prints a message on stderr and counts a failure, so that study_end returns 1. */
STUDY_FN void study_fail(const char *sentence, ...) {
    va_list arguments;
    study.failures++;
    fprintf(stderr, "%s%s: ", study.open ? "\n" : "", study.program ? study.program : "study");
    study.open = 0;
    va_start(arguments, sentence);
    vfprintf(stderr, sentence, arguments);
    va_end(arguments);
    fputc('\n', stderr);
}

/* Returns zeroed memory; ends the program if there is none. */
STUDY_FN void *study_alloc(size_t count, size_t size) {
    void *memory = calloc(count ? count : 1, size);
    if (!memory) { study_fail("no memory for %.0f bytes", (double)count*(double)size); exit(1); }
    return memory;
}

/* ---- options ---- */

typedef enum study_kind { STUDY_FLAG, STUDY_INT, STUDY_REAL, STUDY_TEXT, STUDY_CHOICE } study_kind;
typedef struct study_option {
    const char *name;             /* without the dashes */
    study_kind kind;
    void *value;                  /* int *, int *, double *, const char **, const char ** */
    double lo, hi;                /* limits of numbers */
    const char *unit;             /* unit; of a choice: "one|another" */
    const char *help;
} study_option;

/* Help text of the flag --short. Every study accepts it together with all its other options; tests/studies.sh uses it. */
#define STUDY_SHORT "for tests: all runs that were asked for, in seconds, whatever else is said of their length"

STUDY_FN void study_help(const char *about, const study_option *table, int count) {
    static const char *const kinds[5] = {"", " N", " X", " TEXT", " WORD"};
    int i;
    printf("%s\n\nusage: %s [options]          defaults are in brackets\n", about, study.program);
    for (i = 0; i < count; i++) {
        const study_option *o = &table[i];
        char left[64], now[128] = "";
        const char *text = o->kind >= STUDY_TEXT ? *(const char **)o->value : 0;
        snprintf(left, sizeof left, "--%s%s", o->name, kinds[o->kind]);
        if (o->kind == STUDY_INT) snprintf(now, sizeof now, " [%d", *(int *)o->value);
        if (o->kind == STUDY_REAL) snprintf(now, sizeof now, " [%g", *(double *)o->value);
        if (text && *text) snprintf(now, sizeof now, " [%s", text);
        printf("  %-20s %s%s%s%s%s%s%s\n", left, o->help, o->kind == STUDY_CHOICE ? ": " : "",
               o->kind == STUDY_CHOICE ? o->unit : "", now, *now && *o->unit && !text ? " " : "",
               *now && !text ? o->unit : "", *now ? "]" : "");
    }
    printf("  %-20s this text\n", "--help");
}

/* Reads --name value, --name=value and --flag into the variables of the table. --help prints the table
   and exits with 0. A wrong option prints a message and exits with 2. */
STUDY_FN void study_options(int argc, char **argv, const char *about, const study_option *table,
                            int count) {
    int i, k, bad;
    const char *slash = strrchr(argv[0], '/');
    study.program = slash ? slash + 1 : argv[0];
    for (i = 1; i < argc; i++)
        if (!strcmp(argv[i], "--help")) { study_help(about, table, count); exit(0); }
    for (i = 1; i < argc; i++) {
        const char *word = argv[i], *equal = strchr(word, '='), *value;
        size_t length = equal ? (size_t)(equal - word) : strlen(word);
        const study_option *o = 0;
        char *end = 0, list[128], sought[128];
        double number;
        for (k = 0; k < count && !o; k++)
            if (length > 2 && !strncmp(word, "--", 2) && strlen(table[k].name) + 2 == length &&
                !strncmp(word + 2, table[k].name, length - 2)) o = &table[k];
        if (!o) { study_fail("unknown option %s; --help lists those there are", word); exit(2); }
        if (o->kind == STUDY_FLAG && !equal) { *(int *)o->value = 1; continue; }
        value = equal ? equal + 1 : i + 1 < argc ? argv[++i] : 0;
        snprintf(list, sizeof list, "|%s|", o->unit);
        snprintf(sought, sizeof sought, "|%s|", value ? value : "");
        number = o->kind == STUDY_INT || o->kind == STUDY_REAL ? strtod(value ? value : "", &end)
                                                               : 0;
        bad = end && (end == value || *end || !(number >= o->lo && number <= o->hi) ||
                      (o->kind == STUDY_INT && floor(number) != number));
        if (o->kind == STUDY_FLAG) study_fail("--%s takes no value", o->name);
        else if (!value) study_fail("--%s needs a value", o->name);
        else if (o->kind == STUDY_CHOICE && !strstr(list, sought))
            study_fail("--%s is one of %s, not '%s'", o->name, o->unit, value);
        else if (bad)
            study_fail("--%s needs a %s from %g to %g%s%s, not '%s'", o->name,
                       o->kind == STUDY_INT ? "whole number" : "number", o->lo, o->hi,
                       *o->unit ? " " : "", o->unit, value);
        if (study.failures) exit(2);
        if (o->kind >= STUDY_TEXT) *(const char **)o->value = value;
        else if (o->kind == STUDY_INT) *(int *)o->value = (int)number;
        else *(double *)o->value = number;
    }
}

/* ---- folders, files, results ---- */

/* Makes a folder and those above it. A failure appears when files are opened. */
STUDY_FN void study_make_folder(const char *path) {
    char part[512] = "mkdir ";
    size_t i;
    for (i = 0; path[i] && i + 7 < sizeof part; i++) {
        part[i + 6] = path[i];
        if (path[i + 1] != '/' && path[i + 1] != 0) continue;
#ifdef STUDY_POSIX
        if (mkdir(part + 6, 0777) && errno != EEXIST) return;
#else
        if (system(part)) continue; /* it may exist already */
#endif
    }
}

/* Returns the path of a file in the present folder. It is valid during the next three calls. */
STUDY_FN const char *study_path(const char *name) {
    static char paths[4][1024];
    static int next;
    next = (next + 1)%4;
    snprintf(paths[next], sizeof paths[next], "%s/%s", study.folder, name);
    return paths[next];
}
STUDY_FN FILE *study_open(const char *name) {
    FILE *file;
    if (study.quiet) return 0;
    file = fopen(study_path(name), "wb");
    if (!file) study_fail("cannot write %s: %s", study_path(name), strerror(errno));
    return file;
}
STUDY_FN void study_close(FILE *file, const char *name) {
    int bad = file && ferror(file);
    if (!file) return;
    bad |= fclose(file);
    if (bad) study_fail("%s was not written in full: is the disk full?", study_path(name));
    else study.files++;
}

STUDY_FN void study_begin(const char *folder) {
    snprintf(study.root, sizeof study.root, "%s", folder);
    snprintf(study.folder, sizeof study.folder, "%s", folder);
    if (study.quiet) return;
    study_make_folder(folder);
    study_close(study_open("summary.txt"), "summary.txt");
    if (study.failures) exit(1);
}
/* From now on files go to this folder inside that of the study, and names of results begin with its
   name; "": back to the folder of the study. */
STUDY_FN void study_part(const char *name) {
    snprintf(study.folder, sizeof study.folder, "%s%s%s", study.root, *name ? "/" : "", name);
    snprintf(study.prefix, sizeof study.prefix, "%s%s", name, *name ? "_" : "");
    study_make_folder(study.folder);
}

STUDY_FN void study_result_text(const char *name, const char *value, const char *unit) {
    char text[512];
    FILE *file;
    if (study.quiet) return;
    snprintf(text, sizeof text, "%s/summary.txt", study.root);
    file = fopen(text, "ab");
    snprintf(text, sizeof text, "%s%s = %s%s%s\n", study.prefix, name, value, *unit ? " " : "",
             unit);
    fputs(text, stdout);
    fflush(stdout);
    if (!file || fputs(text, file) < 0 || fclose(file))
        study_fail("cannot write summary.txt in %s", study.root);
}
STUDY_FN void study_result(const char *name, double value, const char *unit) {
    char text[64];
    const int whole = floor(value) >= value && fabs(value) < 1e15;
    snprintf(text, sizeof text, whole ? "%.0f" : "%.6g", value);
    study_result_text(name, text, unit);
    if (value != value) study_fail("%s%s could not be measured", study.prefix, name);
}

/* Prints a note on stderr; it does not count as a failure. */
STUDY_FN void study_say(const char *sentence, ...) {
    va_list arguments;
    if (study.quiet) return;
    fprintf(stderr, "%s%s: ", study.open ? "\n" : "", study.program ? study.program : "study");
    study.open = 0;
    va_start(arguments, sentence);
    vfprintf(stderr, sentence, arguments);
    va_end(arguments);
    fputc('\n', stderr);
}
STUDY_FN void study_replay_print(void) {
    if (study.replay[0]) study_say("open %s in a browser: it plays the run", study.replay);
    study.replay[0] = 0;
}
STUDY_FN int study_end(void) { /* returns the exit code; prints the file of the replay last, below all results */
    fflush(stdout);
    if (!study.quiet)
        fprintf(stderr, "%s: %d files in %s\n", study.program, study.files, study.root);
    study_replay_print();
    if (study.failures) fprintf(stderr, "%s: failures above: %d\n", study.program, study.failures);
    return study.failures ? 1 : 0;
}

/* Writes a table: columns of `rows` numbers each, under a heading such as "time_s,torque_Nm". */
STUDY_FN void study_csv(const char *name, const char *heading, int rows, int columns,
                        const double *const *column) {
    FILE *file = study_open(name);
    int r, c;
    if (!file) return;
    fprintf(file, "%s\n", heading);
    for (r = 0; r < rows; r++)
        for (c = 0; c < columns; c++)
            fprintf(file, "%.9g%c", column[c][r], c + 1 < columns ? ',' : '\n');
    study_close(file, name);
}

/* ---- progress ---- */

/* Reports the progress of the task `what`: done, 0 to 1; work, grains times steps since it began. The
   first call for a new `what` starts its clock; the call with done = 1 ends the line. On a terminal
   one line is rewritten, a file gets a line every 10 %. */
STUDY_FN void study_progress(const char *what, double done, double work) {
    double now = study_clock(), spent, left;
    int terminal = study_terminal();
    if (study.quiet) return;
    if (strcmp(study.told, what)) {
        snprintf(study.told, sizeof study.told, "%s", what);
        study.begun = study.shown = now;
        study.tenths = (int)(10*done + 1e-9);
        return;
    }
    if (terminal ? now - study.shown < 0.2 && done < 1 : (int)(10*done + 1e-9) <= study.tenths)
        return;
    study.shown = now;
    study.tenths = (int)(10*done + 1e-9);
    spent = now - study.begun;
    left = done < 1 ? spent*(1 - done)/(done > 0 ? done : 1) : spent;
    fprintf(stderr, "%s%s %3.0f %%  %6.2f M particle-steps/s  %d:%02d %s%s", terminal ? "\r" : "",
            what, 100*done, spent > 0 ? 1e-6*work/spent : 0, (int)left/60, (int)left%60,
            done < 1 ? "left " : "spent", terminal && done < 1 ? "" : "\n");
    fflush(stderr);
    study.open = terminal && done < 1;
    if (done >= 1) study.told[0] = 0;
}

/* ---- pictures ---- */

typedef enum study_style {
    STUDY_LINE, STUDY_DASHED, STUDY_FAINT, STUDY_DOTS, STUDY_OUTLINE
} study_style;
typedef struct study_series {
    const char *name;             /* in the legend; null: not in it */
    study_style style;
    int count;
    const double *x, *y;
} study_series;

/* A figure: curves over a map (value), over arrows (u, v) or over discs (disc_*). Set all to zero, then
   fill it in. */
#define STUDY_CURVES 20
typedef struct study_figure {
    const char *title, *x_label, *y_label;
    double size;                  /* width of the plot; 0: 620 */
    double x0, x1, y0, y1;        /* range; equal: that of the curves */
    int equal, log_x, log_y;      /* one scale for both axes; logarithmic axes */
    int curve_count;
    study_series curves[STUDY_CURVES];
    int nx, ny;                   /* cells over the range */
    const double *value;          /* map, nx x ny; NaN stays white */
    const double *u, *v;          /* nx x ny arrows, coloured by length */
    int disc_count;
    const double *disc_x, *disc_y, *disc_r, *disc_value;
    const char *bar_label;
    double lo, hi;                /* range of the colours; equal: 0 to the largest */
} study_figure;

STUDY_FN void study_curve(study_figure *f, const char *name, study_style style, int count,
                          const double *x, const double *y) {
    study_series s;
    s.name = name; s.style = style; s.count = count; s.x = x; s.y = y;
    if (f->curve_count < STUDY_CURVES) f->curves[f->curve_count++] = s;
}

/* Returns the colour of a value, 0 to 1, in the scale Viridis: its lightness grows evenly, which the colour-blind see, too.
   Valid until the next call. */
STUDY_FN const char *study_colour(double t) {
    static const unsigned char anchor[11][3] = {
        {68, 1, 84}, {72, 36, 117}, {65, 68, 135}, {53, 95, 141}, {42, 120, 142}, {33, 145, 140},
        {34, 168, 132}, {68, 191, 112}, {122, 209, 81}, {189, 223, 38}, {253, 231, 37}};
    static char text[8];
    double at = 10*(t > 0 ? t < 1 ? t : 1 : 0);
    unsigned i = at < 10 ? (unsigned)at : 9, c, rgb[3];
    for (c = 0; c < 3; c++)
        rgb[c] = (unsigned)(anchor[i][c] + (at - i)*(anchor[i + 1][c] - anchor[i][c]) + 0.5) & 255u;
    snprintf(text, sizeof text, "#%02x%02x%02x", rgb[0], rgb[1], rgb[2]);
    return text;
}

STUDY_FN void study_text(FILE *f, double x, double y, const char *anchor, int size, int turn,
                         const char *text) {
    fprintf(f, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" font-size=\"%d\"", x, y, anchor,
            size);
    if (size > 16) fputs(" font-weight=\"bold\"", f);
    if (turn) fprintf(f, " transform=\"rotate(-90 %.1f %.1f)\"", x, y);
    for (fputc('>', f); *text; text++)
        if (*text == '&' || *text == '<') fputs(*text == '&' ? "&amp;" : "&lt;", f);
        else fputc(*text, f);
    fputs("</text>\n", f);
}

/* Chooses about `most` ticks at 1, 2 or 5 times a power of ten; on a logarithmic axis at powers of
   ten. */
STUDY_FN int study_ticks(double lo, double hi, int logarithmic, int most, double at[20]) {
    int count = 0, k;
    double step = 1, power, want = (hi - lo)/most;
    if (!logarithmic) {
        power = pow(10, floor(log10(want)));
        step = power*(want <= power ? 1 : want <= 2*power ? 2 : want <= 5*power ? 5 : 10);
    }
    for (k = (int)ceil(lo/step - 1e-6); k*step <= hi + 1e-6*step && count < 20; k++)
        at[count++] = k*step;
    return count;
}

/* Returns the level of colour of a cell, of 64; -1 for an empty cell. */
STUDY_FN int study_level(const study_figure *f, int cell, const double *range) {
    double value = f->value ? f->value[cell] : hypot(f->u[cell], f->v[cell]);
    double at = 64*(value - range[0])/(range[1] - range[0]);
    return at != at ? -1 : at < 0 ? 0 : at >= 64 ? 63 : (int)at;
}

/* Draws cells as runs of equal colour (map) or as arrows, one path per colour, so that files are small. */
STUDY_FN void study_cells(FILE *file, const study_figure *f, double left, double top, double w,
                          double h, const double *range) {
    double dx = w/f->nx, dy = h/f->ny, a, b, n, wide;
    int level, k, from;
    for (level = 0; level < 64; level++) {
        fprintf(file, "<path fill=\"%s\"%s d=\"M0 0", study_colour((level + 0.5)/64),
                f->value ? " shape-rendering=\"crispEdges\"" : "");
        for (k = 0; k < f->nx*f->ny; k++) {
            double x = left + (k%f->nx)*dx, y = top + h - (k/f->nx + 1)*dy; /* corner of the cell */
            if (study_level(f, k, range) != level) continue;
            if (f->value) { /* as far as the colour stays the same */
                for (from = k; (k + 1)%f->nx && study_level(f, k + 1, range) == level;) k++;
                a = (k + 1 - from)*dx;
                fprintf(file, "M%.2f %.2fh%.2fv%.2fh%.2fz", x, y, a, dy, -a);
            } else { /* tip, barb, notch, barb; the longest arrow has 2.5 cells */
                a = 2.5*dx*f->u[k]/range[1];
                b = -2.5*dx*f->v[k]/range[1];
                n = hypot(a, b);
                wide = n < 1.1*dx ? 0.3 : 0.16;
                if (n < 0.7*dx && n > 0) { a *= 0.7*dx/n; b *= 0.7*dx/n; }
                fprintf(file, "M%.2f %.2fl%.2f %.2fl%.2f %.2fl%.2f %.2fz", x + (dx + a)/2,
                        y + (dy + b)/2, -a - wide*b, -b + wide*a, 0.22*a + wide*b,
                        0.22*b - wide*a, -0.22*a + wide*b, -0.22*b - wide*a);
            }
        }
        fputs("\"/>\n", file);
    }
}

/* Finds the ranges that the caller left open: r = x0, x1, y0, y1 (logarithms on logarithmic axes), lo, hi. */
STUDY_FN void study_ranges(const study_figure *f, double r[6]) {
    int c, i, axis;
    r[0] = f->x0; r[1] = f->x1; r[2] = f->y0; r[3] = f->y1; r[4] = f->lo; r[5] = f->hi;
    for (axis = 0; axis < 2; axis++) {
        double *lo = r + 2*axis, *hi = lo + 1, room;
        int count = 0, dots = 0, logarithmic = axis ? f->log_y : f->log_x;
        if (*lo != *hi) continue;
        for (c = 0; c < f->curve_count; c++)
            for (i = 0; i < f->curves[c].count; i++) {
                double p = axis ? f->curves[c].y[i] : f->curves[c].x[i];
                if (logarithmic) p = log10(p);
                if (!(fabs(p) < 1e300)) continue;
                if (!count || p < *lo) *lo = p;
                if (!count || p > *hi) *hi = p;
                count++;
                dots |= f->curves[c].style == STUDY_DOTS;
            }
        if (!(*hi > *lo)) { /* a constant */
            room = *lo < 0 || *lo > 0 ? 0.1*fabs(*lo) : 0.5;
            *lo -= room;
            *hi += room;
            continue;
        }
        room = axis ? 0.06*(*hi - *lo) : dots ? 0.03*(*hi - *lo) : 0;
        *hi += room;
        if (axis && !logarithmic && *lo >= 0 && *lo < 0.3**hi) *lo = 0;
        else *lo -= room;
    }
    if (r[4] != r[5]) return;
    for (i = 0; i < f->nx*f->ny; i++)
        r[5] = fmax(r[5], f->value ? f->value[i] : hypot(f->u[i], f->v[i]));
    for (i = 0; i < f->disc_count; i++) r[5] = fmax(r[5], f->disc_value[i]);
    if (r[5] == r[4]) r[5] = r[4] + 1;
}

/* Returns the position of a value between lo and hi on a part of the paper. */
STUDY_FN double study_place(double p, int logarithmic, const double *range, double from,
                            double length) {
    return from + length*((logarithmic ? log10(p) : p) - range[0])/(range[1] - range[0]);
}

/* The beginning of a line's path; a dot. */
STUDY_FN void study_stroke(FILE *file, study_style style, const char *colour) {
    fprintf(file, "<path fill=\"none\" clip-path=\"url(#plot)\" stroke=\"%s\" "
            "stroke-width=\"%s\"%s d=\"", colour, style >= STUDY_FAINT ? "1.2" : "2",
            style == STUDY_DASHED ? " stroke-dasharray=\"7 4\"" : "");
}
STUDY_FN void study_dot(FILE *file, double x, double y, double radius, const char *colour) {
    fprintf(file, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.2f\" fill=\"%s\" stroke=\"#fff\" "
            "stroke-width=\".4\"/>\n", x, y, radius, colour);
}

STUDY_FN void study_rectangle(FILE *file, double x, double y, double w, double h,
                              const char *more) {
    fprintf(file, "<rect x=\"%.1f\" y=\"%.2f\" width=\"%.1f\" height=\"%.2f\" %s/>\n", x, y, w, h,
            more);
}

STUDY_FN void study_figure_write(const study_figure *f, const char *name) {
    static const char *const inks[6] = {"#1b6ca8", "#d1495b", "#2a9d5c", "#8e5ea2", "#e08e0b",
                                        "#5b5b5b"};
    FILE *file = study_open(name);
    double r[6], at[20], left = 86, top = 52, w = f->size > 0 ? f->size : 620, h = 0.62*w;
    double right = 40, bottom = 64;
    int bar = f->value || f->u || f->disc_count, c, i, count, ink = 0, entry = 0;
    char text[96];
    if (!file) return;
    study_ranges(f, r);
    if (f->equal) h = w*(r[3] - r[2])/(r[1] - r[0]);
    for (c = 0; c < f->curve_count; c++)
        if (f->curves[c].name) right = fmax(right, 68 + 7.8*(double)strlen(f->curves[c].name));
    if (bar) right += right > 40 ? 90 : 64;

    /* paper, grid, ticks, labels */
    fprintf(file, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" "
            "font-family=\"Helvetica, Arial, sans-serif\" fill=\"#222\">\n", left + w + right,
            top + h + bottom);
    study_rectangle(file, 0, 0, left + w + right, top + h + bottom, "fill=\"#fff\"");
    study_text(file, left, 32, "start", 18, 0, f->title);
    for (c = 0; c < 2; c++) { /* the axes: 0 x, 1 y */
        int logarithmic = c ? f->log_y : f->log_x;
        count = study_ticks(r[2*c], r[2*c + 1], logarithmic, c ? 7 : 8, at);
        for (i = 0; i < count; i++) {
            double p = study_place(at[i], 0, r + 2*c, c ? top + h : left, c ? -h : w);
            double x = c ? left : p, y = c ? p : top + h;
            char along = c ? 'h' : 'v';
            if (!bar)
                fprintf(file, "<path d=\"M%.1f %.1f%c%.1f\" stroke=\"#e4e4e4\"/>\n", x, y, along,
                        c ? w : -h);
            fprintf(file, "<path d=\"M%.1f %.1f%c%d\" stroke=\"#222\"/>\n", x, y, along,
                    c ? -5 : 5);
            snprintf(text, sizeof text, "%.6g", logarithmic ? pow(10, at[i]) : at[i]);
            study_text(file, c ? x - 9 : x, c ? y + 5 : y + 21, c ? "end" : "middle", 14, 0, text);
        }
    }
    study_text(file, left + w/2, top + h + 48, "middle", 15, 0, f->x_label);
    study_text(file, 22, top + h/2, "middle", 15, 1, f->y_label);
    fputs("<clipPath id=\"plot\">\n", file);
    study_rectangle(file, left, top, w, h, "");
    fputs("</clipPath>\n", file);

    /* map or arrows, discs, frame */
    if (f->value || f->u) study_cells(file, f, left, top, w, h, r + 4);
    for (i = 0; i < f->disc_count; i++)
        study_dot(file, study_place(f->disc_x[i], 0, r, left, w),
                  study_place(f->disc_y[i], 0, r + 2, top + h, -h), w*f->disc_r[i]/(r[1] - r[0]),
                  study_colour((f->disc_value[i] - r[4])/(r[5] - r[4])));
    study_rectangle(file, left, top, w, h, "fill=\"none\" stroke=\"#222\"");

    /* curves and legend */
    for (c = 0; c < f->curve_count; c++) {
        const study_series *s = &f->curves[c];
        const char *colour = s->style == STUDY_OUTLINE ? "#222" :
                             s->style == STUDY_FAINT ? "#b9c4cd" : inks[ink++%6];
        double x, y, px = 0, py = 0;
        int down = 0;
        if (s->style != STUDY_DOTS) study_stroke(file, s->style, colour);
        for (i = 0; i < s->count; i++) {
            x = study_place(s->x[i], f->log_x, r, left, w);
            y = study_place(s->y[i], f->log_y, r + 2, top + h, -h);
            if (!(fabs(x) < 1e6 && fabs(y) < 1e6)) down = 0; /* not a number: a gap */
            else if (s->style == STUDY_DOTS) study_dot(file, x, y, 3.5, colour);
            else if (!down || i + 1 == s->count || fabs(x - px) > 0.4 || fabs(y - py) > 0.4) {
                fprintf(file, "%c%.1f %.1f", down++ ? 'L' : 'M', x, y);
                px = x;
                py = y;
            }
        }
        if (s->style != STUDY_DOTS) fputs("\"/>\n", file);
        if (!s->name) continue;
        x = left + w + 16 + (bar ? 90 : 0);
        y = top + 12 + 22*entry++;
        if (s->style == STUDY_DOTS) study_dot(file, x + 12, y, 3.5, colour);
        else {
            study_stroke(file, s->style, colour);
            fprintf(file, "M%.1f %.1fh24\" style=\"clip-path:none\"/>\n", x, y);
        }
        study_text(file, x + 31, y + 5, "start", 14, 0, s->name);
    }

    /* colour bar */
    for (i = 0; i < 64 && bar; i++) {
        snprintf(text, sizeof text, "fill=\"%s\" shape-rendering=\"crispEdges\"",
                 study_colour((i + 0.5)/64));
        study_rectangle(file, left + w + 18, top + h*(63 - i)/64, 16, h/64 + 0.5, text);
    }
    count = bar ? study_ticks(r[4], r[5], 0, 7, at) : 0;
    for (i = 0; i < count; i++) {
        snprintf(text, sizeof text, "%.6g", at[i]);
        study_text(file, left + w + 40, study_place(at[i], 0, r + 4, top + h, -h) + 5, "start", 14,
                   0, text);
    }
    if (bar && f->bar_label)
        study_text(file, left + w + 92, top + h/2, "middle", 15, 1, f->bar_label);
    fputs("</svg>\n", file);
    study_close(file, name);
}

#endif /* STUDY_H */
