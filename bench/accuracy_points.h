/* accuracy_points.h - points of a work-precision diagram: which are efficient, a picture, tables. MIT licence.

   A point is one setting: its cost and its error. Cost is processor time in units of the library's own setting, so that it
   hardly depends on the machine. Where results scatter, an error has a bar (the standard error of the difference), and all
   errors below the diagram's level of chance count as equal: the cheapest of these settings is the efficient one.

       points_clear(&p, "hopper");
       points_add(&p, "default settings", "t_c/50", 1, 0.004, 0.006);     // series, label, cost, error, bar
       points_front(&p);
       points_draw(&p, "title", "cost", "error", "hopper.svg");

   Needs examples/study.h and bench/measure.h before it. */
#ifndef ACCURACY_POINTS_H
#define ACCURACY_POINTS_H

enum { POINTS_MOST = 160, POINTS_SERIES = 14, POINTS_BOXES = 3*POINTS_MOST, POINTS_NUMBERS = 16 };
typedef struct point {
    int series;
    char label[32];
    double cost, error, bar;        /* bar: 0 where chance does not enter                                    */
    int front;                      /* 1: efficient: nothing is both cheaper and more accurate               */
} point;
typedef struct number {              /* another result of a diagram, for accuracy_numbers.csv                 */
    char what[80];
    const char *unit;
    double value, bar;              /* bar: standard error, 0 if there is none                               */
    int seeds;                      /* 0: results do not scatter                                             */
} number;
typedef struct points {
    const char *name, *unit;        /* unit: of the observable                                               */
    int count, series_count;
    point at[POINTS_MOST];
    const char *series[POINTS_SERIES];
    double chance;                  /* errors below are not significant                                      */
    int plain;                      /* 1: not error over cost; the lowest point of all is ringed             */
    double mark;                    /* a published number, drawn across; 0: none                             */
    const char *mark_name;
    number number[POINTS_NUMBERS];
    int number_count;
    char remark[200];               /* written into the picture                                              */
} points;

static void points_clear(points *p, const char *name) {
    memset(p, 0, sizeof *p);
    p->name = name;
}
static void points_add(points *p, const char *series, const char *label, double cost, double error, double bar) {
    point *q = &p->at[p->count];
    int k = 0;
    while (k < p->series_count && strcmp(p->series[k], series)) k++;
    if (p->count == POINTS_MOST || k == POINTS_SERIES) { study_fail("%s: too many points or series", p->name); return; }
    if (k == p->series_count) p->series[p->series_count++] = series;
    memset(q, 0, sizeof *q);
    q->series = k;
    snprintf(q->label, sizeof q->label, "%s", label);
    q->cost = cost;
    q->error = fabs(error);
    q->bar = bar;
    p->count++;
}
static void points_number(points *p, const char *what, double value, double bar, const char *unit, int seeds) {
    number *n = &p->number[p->number_count];
    if (p->number_count == POINTS_NUMBERS) { study_fail("%s: too many numbers", p->name); return; }
    snprintf(n->what, sizeof n->what, "%s", what);
    n->unit = unit ? unit : "";
    n->value = value;
    n->bar = bar;
    n->seeds = seeds;
    p->number_count++;
}
static int point_is(const point *q) { return q->cost > 0 && q->cost < 1e300 && q->error >= 0 && q->error < 1e300; }

/* Of a series that leaves something out ("friction without memory"): another model, not a coarser setting. */
static int points_aside(const points *p, const point *q) { return strstr(p->series[q->series], "without") != 0; }
/* Marks the efficient points: no other is as near and as cheap, or better in one of the two. 4 % count as nothing. */
static void points_front(points *p) {
    const double same = 1.04;
    double bars[BENCH_MOST_LOOPS];
    int i, k, count = 0;
    for (i = 0; i < p->count; i++)
        if (p->at[i].bar > 0 && count < BENCH_MOST_LOOPS) bars[count++] = p->at[i].bar;
    p->chance = count ? 2*bench_median(bars, count) : 0;
    for (i = 0; i < p->count; i++) {
        point *a = &p->at[i];
        const double near = fmax(a->error, p->chance);
        a->front = point_is(a) && !points_aside(p, a);
        for (k = 0; k < p->count && a->front; k++) {
            const point *b = &p->at[k];
            const double other = fmax(b->error, p->chance), cheaper = p->plain ? 1 : a->cost/b->cost;
            if (k == i || !point_is(b) || points_aside(p, b) || cheaper < 1/same || other > near*same) continue;
            a->front = !(cheaper > same || other < near/same || k < i);
        }
    }
}

/* ---- picture ---- */

static const char *const points_inks[POINTS_SERIES] = {
    "#1b6ca8", "#d1495b", "#2a9d5c", "#8e5ea2", "#e08e0b", "#5b5b5b", "#17a2b8", "#a0522d", "#c71585", "#7a8b00",
    "#3d405b", "#b22222", "#006d77", "#9c6644"};
typedef struct sheet {               /* a picture under way                                                  */
    FILE *file;
    double left, top, w, h, range[4]; /* place on the paper; x0, x1, y0, y1, logarithms where the axis is    */
    int log_x, log_y, boxes;
    double box[POINTS_BOXES][4];     /* what is taken: x0, y0, x1, y1                                        */
} sheet;

static double sheet_x(const sheet *s, double x) { return study_place(x, s->log_x, s->range, s->left, s->w); }
static double sheet_y(const sheet *s, double y) { return study_place(y, s->log_y, s->range + 2, s->top + s->h, -s->h); }
static void sheet_take(sheet *s, double x0, double y0, double x1, double y1) {
    double *b = s->box[s->boxes < POINTS_BOXES ? s->boxes++ : POINTS_BOXES - 1];
    b[0] = x0; b[1] = y0; b[2] = x1; b[3] = y1;
}
/* Beside a point, where nothing is yet; not at all where there is no room. */
static void sheet_label(sheet *s, double x, double y, const char *text) {
    static const double place[8][2] = {{1, -1}, {1, 1}, {-1, -1}, {-1, 1}, {0, -2}, {0, 2}, {1, -2.6}, {1, 2.6}};
    const double wide = 6.6*(double)strlen(text);
    int k, i;
    for (k = 0; k < 8; k++) {
        const double x0 = place[k][0] > 0 ? x + 11 : place[k][0] < 0 ? x - 11 - wide : x - wide/2;
        const double y0 = y + 9*place[k][1] - 6, x1 = x0 + wide, y1 = y0 + 12;
        int bad = x0 < s->left + 2 || x1 > s->left + s->w - 2 || y0 < s->top + 1 || y1 > s->top + s->h - 1;
        for (i = 0; i < s->boxes && !bad; i++)
            bad = x0 < s->box[i][2] && x1 > s->box[i][0] && y0 < s->box[i][3] && y1 > s->box[i][1];
        if (bad) continue;
        sheet_take(s, x0, y0, x1, y1);
        study_text(s->file, x0, y1 - 2, "start", 12, 0, text);
        return;
    }
}
/* Ticks of a logarithmic axis: powers of ten, every second or third where there are many; 1, 2, 5 on a short one. */
static int sheet_ticks(double lo, double hi, double at[20]) {
    const double steps[3] = {0, log10(2), log10(5)};
    const int wide = hi - lo > 2.2, each = hi - lo > 16 ? 4 : hi - lo > 8 ? 2 : 1;
    int count = 0, k, j;
    for (k = (int)floor(lo); k <= (int)ceil(hi); k++)
        for (j = 0; j < (wide ? 1 : 3); j++) {
            const double t = k + steps[j];
            if (t >= lo - 1e-9 && t <= hi + 1e-9 && count < 20 && (!wide || k%each == 0)) at[count++] = t;
        }
    return count;
}
/* Paper, axes, ticks, title. right: room beside the plot. */
static void sheet_begin(sheet *s, const char *title, const char *x_label, const char *y_label, double right) {
    double at[20];
    char text[64];
    int c, i, count;
    s->left = 92; s->top = 52; s->w = 620; s->h = 390; s->boxes = 0;
    fprintf(s->file, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" "
            "font-family=\"Helvetica, Arial, sans-serif\" fill=\"#222\">\n", s->left + s->w + right,
            s->top + s->h + 64);
    study_rectangle(s->file, 0, 0, s->left + s->w + right, s->top + s->h + 64, "fill=\"#fff\"");
    study_text(s->file, s->left, 32, "start", 18, 0, title);
    for (c = 0; c < 2; c++) {        /* 0: x, 1: y                                                           */
        const int logarithmic = c ? s->log_y : s->log_x;
        count = logarithmic ? sheet_ticks(s->range[2*c], s->range[2*c + 1], at)
                            : study_ticks(s->range[2*c], s->range[2*c + 1], 0, c ? 8 : 9, at);
        for (i = 0; i < count; i++) {
            const double value = logarithmic ? pow(10, at[i]) : at[i];
            const double x = c ? s->left : sheet_x(s, value), y = c ? sheet_y(s, value) : s->top + s->h;
            fprintf(s->file, "<path d=\"M%.1f %.1f%c%.1f\" stroke=\"#e4e4e4\"/>\n", x, y, c ? 'h' : 'v',
                    c ? s->w : -s->h);
            fprintf(s->file, "<path d=\"M%.1f %.1f%c%d\" stroke=\"#222\"/>\n", x, y, c ? 'h' : 'v', c ? -5 : 5);
            snprintf(text, sizeof text, logarithmic && (value < 9.9e-4 || value > 1.1e5) ? "%.0e" : "%.4g",
                     fabs(value) < 1e-12 && !logarithmic ? 0.0 : value);
            study_text(s->file, c ? x - 9 : x, c ? y + 5 : y + 21, c ? "end" : "middle", 14, 0, text);
        }
    }
    study_text(s->file, s->left + s->w/2, s->top + s->h + 48, "middle", 15, 0, x_label);
    study_text(s->file, 22, s->top + s->h/2, "middle", 15, 1, y_label);
    fputs("<clipPath id=\"plot\">\n", s->file);
    study_rectangle(s->file, s->left, s->top, s->w, s->h, "");
    fputs("</clipPath>\n", s->file);
}
static void sheet_end(sheet *s, const char *name) {
    study_rectangle(s->file, s->left, s->top, s->w, s->h, "fill=\"none\" stroke=\"#222\"");
    fputs("</svg>\n", s->file);
    study_close(s->file, name);
}
/* A grey band across from y0 to y1, with its name at the bottom. */
static void sheet_band(sheet *s, double y0, double y1, const char *fill, const char *text) {
    const double a = fmin(sheet_y(s, y0), s->top + s->h), b = fmax(sheet_y(s, y1), s->top);
    char more[64];
    if (!(a > b)) return;
    snprintf(more, sizeof more, "fill=\"%s\"", fill);
    study_rectangle(s->file, s->left, b, s->w, a - b, more);
    if (text && a - b > 16) study_text(s->file, s->left + s->w - 8, a - 5, "end", 12, 0, text);
    if (text) sheet_take(s, s->left + s->w - 8 - 7*(double)strlen(text), a - 17, s->left + s->w, a);
}
static void sheet_dot(sheet *s, const point *q, const char *ink, int hollow) {
    const double x = sheet_x(s, q->cost), y = sheet_y(s, q->error);
    if (q->bar > 0) {
        const double floor_y = s->top + s->h, low = q->error - q->bar;
        const double a = sheet_y(s, q->error + q->bar), b = low > 0 || !s->log_y ? sheet_y(s, low) : floor_y;
        fprintf(s->file, "<path fill=\"none\" clip-path=\"url(#plot)\" stroke=\"%s\" opacity=\".55\" "
                "d=\"M%.1f %.1fV%.1fM%.1f %.1fh6M%.1f %.1fh6\"/>\n", ink, x, a, b, x - 3, a, x - 3, b);
    }
    fprintf(s->file, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"%s\" stroke=\"%s\" stroke-width=\"1.5\"/>\n", x, y,
            hollow ? "#fff" : ink, ink);
    if (q->front) fprintf(s->file, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"8\" fill=\"none\" stroke=\"#222\" "
                          "stroke-width=\"1.4\"/>\n", x, y);
}

static int points_by_cost(const void *a, const void *b) {
    const point *p = *(const point *const *)a, *q = *(const point *const *)b;
    return p->cost < q->cost ? -1 : p->cost > q->cost;
}
/* Range of both axes, with room; errors of nothing are drawn on the floor. */
static void points_range(points *p, sheet *s) {
    double lo[2] = {1e300, 1e300}, hi[2] = {0, 0}, least;
    int i;
    for (i = 0; i < p->count; i++) {
        const point *q = &p->at[i];
        if (!point_is(q)) continue;
        lo[0] = fmin(lo[0], q->cost); hi[0] = fmax(hi[0], q->cost);
        hi[1] = fmax(hi[1], q->error + q->bar);
        if (q->error > 0) lo[1] = fmin(lo[1], q->error);
    }
    if (!(hi[0] > 0)) { lo[0] = lo[1] = 0.1; hi[0] = hi[1] = 1; }
    if (p->chance > 0) lo[1] = fmax(fmin(lo[1], p->chance/2), p->chance/20);
    if (p->mark > 0) { lo[1] = fmin(lo[1], p->mark); hi[1] = fmax(hi[1], p->mark); }
    least = p->plain ? lo[1] : fmin(lo[1], hi[1]/10);
    s->log_x = s->log_y = 1;
    s->range[0] = log10(lo[0]) - 0.06*fmax(log10(hi[0]/lo[0]), 0.5);
    s->range[1] = log10(hi[0]) + 0.06*fmax(log10(hi[0]/lo[0]), 0.5);
    s->range[2] = log10(least) - 0.08*fmax(log10(hi[1]/least), 0.5);
    s->range[3] = log10(hi[1]) + 0.08*fmax(log10(hi[1]/least), 0.5);
    for (i = 0; i < p->count; i++)
        if (point_is(&p->at[i])) p->at[i].error = fmax(p->at[i].error, pow(10, s->range[2]));
}
static void points_legend(sheet *s, const points *p, const int *used) {
    const double x = s->left + s->w + 16;
    double y = s->top + 12;
    int k;
    for (k = 0; k < p->series_count; k++) {
        if (!used[k]) continue;
        study_dot(s->file, x + 10, y, 4.5, points_inks[k]);
        study_text(s->file, x + 24, y + 5, "start", 14, 0, p->series[k]);
        y += 21;
    }
    y += 8;
    fprintf(s->file, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"8\" fill=\"none\" stroke=\"#222\" stroke-width=\"1.4\"/>\n",
            x + 10, y);
    study_text(s->file, x + 24, y + 5, "start", 14, 0, "efficient");
    if (!(p->chance > 0)) return;
    fprintf(s->file, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"#fff\" stroke=\"#222\" stroke-width=\"1.5\"/>\n",
            x + 10, y + 22);
    study_text(s->file, x + 24, y + 27, "start", 14, 0, "within chance");
}
/* Error over cost, the efficient points ringed and joined. */
static void points_draw(points *p, const char *title, const char *x_label, const char *y_label, const char *file) {
    static sheet s;
    const point *sorted[POINTS_MOST];
    int i, k, down = 0, used[POINTS_SERIES] = {0};
    double right = 150;
    s.file = study_open(file);
    if (!s.file) return;
    points_range(p, &s);
    for (i = 0; i < p->count; i++) if (point_is(&p->at[i])) used[p->at[i].series] = 1;
    for (k = 0; k < p->series_count; k++) right = fmax(right, 56 + 7.4*(double)strlen(p->series[k]));
    sheet_begin(&s, title, x_label, y_label, right);
    if (p->chance > 0) sheet_band(&s, pow(10, s.range[2]), p->chance, "#f0f0ea", "chance (two standard errors)");
    if (p->mark > 0) {
        const double y = sheet_y(&s, p->mark);
        study_stroke(s.file, STUDY_DASHED, "#222");
        fprintf(s.file, "M%.1f %.1fh%.1f\"/>\n", s.left, y, s.w);
        sheet_take(&s, s.left, y - 2, s.left + s.w, y + 2);
        study_text(s.file, s.left + 8, y - 6, "start", 12, 0, p->mark_name);
        sheet_take(&s, s.left + 8, y - 18, s.left + 8 + 7*(double)strlen(p->mark_name), y);
    }
    for (i = 0; i < p->count; i++) {
        const point *q = sorted[i] = &p->at[i];
        if (point_is(q)) {
            const double x = sheet_x(&s, q->cost), y = sheet_y(&s, q->error), half = q->front ? 8 : 5;
            sheet_take(&s, x - half, y - half, x + half, y + half);
        }
    }
    qsort(sorted, (size_t)p->count, sizeof *sorted, points_by_cost);
    for (k = -1; k < p->series_count; k++) { /* -1: the front                                                */
        if (k < 0) fputs("<path fill=\"none\" clip-path=\"url(#plot)\" stroke=\"#c9c9c0\" stroke-width=\"7\" "
                         "stroke-linejoin=\"round\" d=\"", s.file);
        else fprintf(s.file, "<path fill=\"none\" clip-path=\"url(#plot)\" stroke=\"%s\" opacity=\".6\" "
                     "d=\"", points_inks[k]);
        for (i = down = 0; i < p->count; i++)
            if (point_is(sorted[i]) && (k < 0 ? sorted[i]->front : sorted[i]->series == k))
                fprintf(s.file, "%c%.1f %.1f", down++ ? 'L' : 'M', sheet_x(&s, sorted[i]->cost),
                        sheet_y(&s, sorted[i]->error));
        fputs("\"/>\n", s.file);
    }
    for (i = 0; i < p->count; i++) {
        const point *q = &p->at[i];
        if (point_is(q)) sheet_dot(&s, q, points_inks[q->series], q->bar > 0 && q->error < p->chance);
    }
    for (i = 0; i < p->count; i++)
        if (point_is(sorted[i]) && sorted[i]->front)
            sheet_label(&s, sheet_x(&s, sorted[i]->cost), sheet_y(&s, sorted[i]->error), sorted[i]->label);
    points_legend(&s, p, used);
    sheet_end(&s, file);
}

/* ---- table ---- */

static void points_word(char *name) { /* names of results have no blanks                                    */
    for (; *name; name++) if (*name == ' ') *name = '_';
}
/* Tables for docs/data, open while diagrams are made; null in variant builds. */
typedef struct accuracy_files { FILE *efficient, *numbers, *softening; } accuracy_files;
static void accuracy_files_open(accuracy_files *f) {
    static const char *const command = "make bench-pages PAGES=accuracy";
    f->efficient = bench_data_open("accuracy_efficient.csv", command,
        "diagram,series,setting,cost [library's own setting = 1],error [1; top: rad],standard error of the error [1],"
        "within chance [0 or 1]");
    f->numbers = bench_data_open("accuracy_numbers.csv", command, "diagram,quantity,value,standard error,unit,seeds");
    f->softening = bench_data_open("accuracy_softening.csv", command,
        "diagram,Young's modulus [true grain = 1],change [%],standard error [%],cost [true grain = 1],"
        "largest overlap [radii]");
}
static void accuracy_files_close(const accuracy_files *f) {
    study_close(f->efficient, "accuracy_efficient.csv");
    study_close(f->numbers, "accuracy_numbers.csv");
    study_close(f->softening, "accuracy_softening.csv");
}
static void points_numbers_write(const points *p, FILE *file) {
    int i;
    for (i = 0; i < p->number_count && file; i++) {
        const number *n = &p->number[i];
        fprintf(file, "%s,\"%s\",", p->name, n->what);
        if (n->value == n->value) fprintf(file, "%.4g", n->value);
        if (n->bar > 0) fprintf(file, ",%.2g", n->bar); else fprintf(file, ",");
        if (n->seeds) fprintf(file, ",%s,%d\n", n->unit, n->seeds); else fprintf(file, ",%s,\n", n->unit);
    }
}
/* All points as lines of results and as NAME.csv; the efficient ones as rows of accuracy_efficient.csv. */
static void points_tell(const points *p, const accuracy_files *files) {
    char name[128], text[96];
    int i;
    snprintf(name, sizeof name, "%s.csv", p->name);
    FILE *file = study_open(name);
    if (file) fprintf(file, "series,setting,cost,error,bar,efficient\n");
    for (i = 0; i < p->count; i++) {
        const point *q = &p->at[i];
        const char *within = q->bar > 0 && q->error < p->chance ? ", within chance" : "";
        if (file) fprintf(file, "\"%s\",\"%s\",%.6g,%.6g,%.3g,%d\n", p->series[q->series], q->label, q->cost,
                          q->error, q->bar, q->front);
        snprintf(name, sizeof name, "%s.%s.%s", p->name, p->series[q->series], q->label);
        points_word(name);
        if (point_is(q)) snprintf(text, sizeof text, "%.3g at cost %.3g%s%s", q->error, q->cost, within,
                                  q->front ? ", efficient" : "");
        else snprintf(text, sizeof text, "none: the run was stopped");
        study_result_text(name, text, "");
        if (!files->efficient || !q->front || p->plain) continue;
        fprintf(files->efficient, "%s,\"%s\",\"%s\",%.2f,%.1e,", p->name, p->series[q->series], q->label, q->cost, q->error);
        if (q->bar > 0) fprintf(files->efficient, "%.1e,%d\n", q->bar, *within != 0); else fprintf(files->efficient, ",0\n");
    }
    if (file) { snprintf(name, sizeof name, "%s.csv", p->name); study_close(file, name); }
    points_numbers_write(p, files->numbers);
}
#endif /* ACCURACY_POINTS_H */
