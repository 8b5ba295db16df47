/* accuracy_studies.h - machines at reduced size: pile, slow drum, hopper, mill, sieve; and what softening changes in
   them. MIT licence. Needs all that bench/accuracy.c includes before it. */
#ifndef ACCURACY_STUDIES_H
#define ACCURACY_STUDIES_H

#define CHOICES(table) ((int)(sizeof table/sizeof *table))

static void fill_scene(points *p, scene_fn scene, const choice *c, int count, int wanted, int what) {
    static outcome out[SCENE_CHOICES*SCENE_SEEDS];
    const int seeds = scene_seeds(wanted);
    scene_measure(p->name, scene, c, count, seeds, out);
    scene_points(p, c, count, seeds, out, what);
    variant_scene(p, c, count, seeds, out, what, 1);
}

/* ---- time step and laws ---- */

static void fill_pile(points *p) {
    static const choice c[] = {
        {.label = "t_c/100", .step = 0.5}, {"default settings", "t_c/50", .step = 1},
        {"default settings", "t_c/20", .step = 2.5}, {"default settings", "t_c/10", .step = 5},
        {"without memory", "viscous", .tangent = DEM_TANGENT_VISCOUS},
        {"without memory", "step", .tangent = DEM_TANGENT_STEP},
        {"friction", "Mindlin", .tangent = DEM_TANGENT_MINDLIN},
        {"friction", "DEM_SLIDER_REMAINDER", .slider = DEM_SLIDER_REMAINDER},
        {"without rolling", "none", .rolling = DEM_ROLLING_NONE},
        {"rolling", "constant", .rolling = DEM_ROLLING_CONSTANT}, {"rolling", "step", .rolling = DEM_ROLLING_STEP}};
    fill_scene(p, scene_pile, c, CHOICES(c), 5, 0);
}
static void fill_slow(points *p) {
    static const choice c[] = {
        {.label = "t_c/100", .step = 0.5}, {"default settings", "t_c/50", .step = 1},
        {"default settings", "t_c/20", .step = 2.5}, {"default settings", "t_c/10", .step = 5},
        {"without memory", "viscous", .tangent = DEM_TANGENT_VISCOUS},
        {"without memory", "step", .tangent = DEM_TANGENT_STEP},
        {"friction", "Mindlin", .tangent = DEM_TANGENT_MINDLIN},
        {"without rolling", "none", .rolling = DEM_ROLLING_NONE},
        {"rolling", "constant", .rolling = DEM_ROLLING_CONSTANT}, {"normal", "linear", .normal = DEM_NORMAL_LINEAR}};
    fill_scene(p, scene_slow, c, CHOICES(c), 3, 1);
}
static void fill_hopper(points *p) {
    static const choice c[] = {
        {.label = "t_c/100", .step = 0.5}, {"default settings", "t_c/50", .step = 1},
        {"default settings", "t_c/20", .step = 2.5}, {"default settings", "t_c/10", .step = 5},
        {"skin", "0.1 R", .skin = 0.1}, {"skin", "1 R", .skin = 1},
        {"search", "linked list", .search = DEM_SEARCH_LINKED_LIST},
        {"without memory", "viscous", .tangent = DEM_TANGENT_VISCOUS},
        {"without memory", "step", .tangent = DEM_TANGENT_STEP},
        {"friction", "Mindlin", .tangent = DEM_TANGENT_MINDLIN}, {"normal", "linear", .normal = DEM_NORMAL_LINEAR}};
    fill_scene(p, scene_hopper, c, CHOICES(c), 6, 0);
}
static void fill_mill(points *p) {
    static const choice c[] = {
        {.label = "t_c/100", .step = 0.5}, {"default settings", "t_c/50", .step = 1},
        {"default settings", "t_c/20", .step = 2.5}, {"default settings", "t_c/10", .step = 5},
        {"integrator", "symplectic", .integrator = DEM_INTEGRATOR_SYMPLECTIC_EULER},
        {"integrator", "forward", .integrator = DEM_INTEGRATOR_FORWARD_EULER},
        {"without memory", "viscous", .tangent = DEM_TANGENT_VISCOUS},
        {"without memory", "step", .tangent = DEM_TANGENT_STEP},
        {"friction", "Mindlin", .tangent = DEM_TANGENT_MINDLIN}, {"normal", "linear", .normal = DEM_NORMAL_LINEAR}};
    fill_scene(p, scene_mill, c, CHOICES(c), 3, 0);
}

/* ---- a shaken sieve: holes of 10 mm, bars of 3, three sizes of balls ---- */

enum { SIEVE_GRAINS = 210 };
static int sieve_build(built *b, const choice *c, int seed) {
    static const dem_sieve_kind kinds[] = {DEM_SIEVE_SQUARE, DEM_SIEVE_SQUARE, DEM_SIEVE_WIRES, DEM_SIEVE_ROUND,
                                           DEM_SIEVE_REDUCED, DEM_SIEVE_REDUCED, DEM_SIEVE_REDUCED, DEM_SIEVE_REDUCED};
    static const double clearance[] = {0, 0, 0, 0, 0, 0.2, 0, 0.2};
    static const int side[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    static const double radius[3] = {4.25e-3, 3.5e-3, 2.5e-3};
    const dem_box box = dem_box_make(DEM_R(-0.06), DEM_R(-0.06), DEM_R(0.01), DEM_R(0.06), DEM_R(0.06), DEM_R(0.1));
    dem_sieve_desc sieve = DEM_SIEVE_DESC;
    dem_motion shaking = DEM_MOTION;
    dem_outlet_desc outlet;
    int k, done = 0;
    b->stuff = scene_material(b->world, c, 0.5, 0.3, 0);
    sieve.kind = kinds[c->kind];
    sieve.aperture = DEM_R(0.010);
    sieve.bar = DEM_R(0.003);
    sieve.thickness = sieve.kind == DEM_SIEVE_SQUARE || sieve.kind == DEM_SIEVE_ROUND ? DEM_R(0.003) : 0;
    sieve.model = c->kind >= 6 ? 2 : c->kind >= 4 ? 1 : 0;
    sieve.clearance = (dem_real)clearance[c->kind];
    b->wall = dem_wall_sieve_add(b->world, b->stuff, &sieve);
    shaking.kind = DEM_MOTION_OSCILLATING;
    shaking.velocity = dem_vec3_make(DEM_R(0.3), DEM_R(0.2), 1);
    shaking.amplitude = DEM_R(0.0015);
    shaking.frequency = 20;
    if (!b->stuff.id || !b->wall.id || dem_wall_motion_set(b->world, b->wall, &shaking) != DEM_OK) return 0;
    for (k = 0; k < 4; k++)
        if (!dem_wall_plane_add(b->world, b->stuff, dem_vec3_make(DEM_R(0.065*side[k][0]), DEM_R(0.065*side[k][1]), 0),
                           dem_vec3_make((dem_real)-side[k][0], (dem_real)-side[k][1], 0)).id) return 0;
    memset(&outlet, 0, sizeof outlet);
    outlet.box = dem_box_make(-1, -1, -10, 1, 1, DEM_R(-0.1));
    b->outlet = dem_outlet_add(b->world, &outlet);
    for (k = 0; k < 3; k++)
        done += dem_spheres_fill(b->world, b->stuff, (dem_real)radius[k], dem_region_make(box), SIEVE_GRAINS/3,
                                 (uint64_t)(10*seed + k));
    return b->outlet.id && done == SIEVE_GRAINS;
}
/* value: share of the balls that is through after a second. */
static outcome scene_sieve(const choice *c, int seed) {
    outcome o = {{0}, 0, 0, 1};
    dem_world_desc desc = scene_desc(c, 3.5e-3, 1);
    dem_bodies bodies;
    built b;
    int i, above = 0;
    desc.gravity.z = DEM_R(-9.81);
    if (!scene_build(&b, desc, c, sieve_build, seed)) return o;
    scene_run(&b, quick ? 0.3 : 1, &o);
    bodies = dem_bodies_get(b.world);
    for (i = 0; i < bodies.count; i++) above += bodies.positions[4*i + 2] > DEM_R(-0.01);
    o.value[0] = 1 - (double)above/SIEVE_GRAINS;
    scene_end(&b, &o);
    return o;
}
static void fill_sieve(points *p) {
    static const choice c[] = {
        {.label = "t_c/100", .step = 0.5}, {"plate, square holes", "t_c/50", .kind = 1},
        {"plate, square holes", "t_c/20", .kind = 1, .step = 2.5},
        {"plate, square holes", "t_c/10", .kind = 1, .step = 5}, {"wires", "t_c/50", .kind = 2},
        {"wires", "t_c/20", .kind = 2, .step = 2.5}, {"plate, round holes", "t_c/50", .kind = 3},
        {"reduced, model 1", "open", .kind = 4}, {"reduced, model 1", "0.2 closed", .kind = 5},
        {"reduced, model 2", "open", .kind = 6}, {"reduced, model 2", "0.2 closed", .kind = 7}};
    fill_scene(p, scene_sieve, c, CHOICES(c), 6, 0);
}

/* ---- softening: how far may E fall? ---- */

enum { SOFTS = 8, LEVELS = 3 };
static const double softs[SOFTS] = {1, 0.1, 0.03, 0.01, 3e-3, 1e-3, 3e-4, 1e-4};
static const double soft_levels[LEVELS] = {0.01, 0.02, 0.05};
typedef struct softening {
    double change[SOFTS], bar[SOFTS], cost[SOFTS], overlap[SOFTS]; /* against a true grain; the bar is of both      */
    double fit[3], misfit;           /* change = fit0 + fit1 s^fit2, s: times softer; rms residual over bars */
    double passes[LEVELS];           /* times softer, where the change passes a level; 0: not by E/10000,
                                        -1: no change is significant                                         */
} softening;

/* Fits all grains down to E/1000 together, since each change alone is hardly significant: least squares, weighted by the
   standard errors, of a constant and a power of the softness (how many times softer than the true grain). Overlaps grow
   with the power 2/5 in impacts and 2/3 under weight, and their effect may level off: the best fit of the powers 0.2 to
   2/3. */
static void soft_fit(softening *s, const double *own) { /* own: bars without that of the true grain             */
    double best = 1e300, sure = 0;
    int k, level, power, count;
    s->fit[0] = s->fit[1] = s->fit[2] = s->misfit = (double)NAN;
    for (power = 4; power <= 13; power++) {
        double w = 0, x = 0, y = 0, xx = 0, xy = 0, a, b, left = 0;
        for (k = count = 0; k < SOFTS; k++) {
            const double u = pow(1/softs[k], 0.05*power), weight = 1/(own[k]*own[k]), v = s->change[k];
            if (softs[k] < 9e-4 || !(v == v)) continue;
            w += weight; x += weight*u; y += weight*v; xx += weight*u*u; xy += weight*u*v;
            count++;
        }
        b = (w*xy - x*y)/(w*xx - x*x);
        a = (y - b*x)/w;
        for (k = 0; k < SOFTS; k++)
            if (softs[k] >= 9e-4 && s->change[k] == s->change[k])
                left += pow((s->change[k] - a - b*pow(1/softs[k], 0.05*power))/own[k], 2);
        if (!(left < best)) continue;
        best = left;
        s->fit[0] = a; s->fit[1] = b; s->fit[2] = 0.05*power;
        sure = fabs(b)*sqrt((w*xx - x*x)/w); /* in standard errors                                           */
        s->misfit = sqrt(left/(count > 3 ? count - 3 : 1));
    }
    for (level = 0; level < LEVELS; level++) {
        const double softer = pow(1 + soft_levels[level]*(1 + s->fit[0] + s->fit[1])/fabs(s->fit[1]), 1/s->fit[2]);
        s->passes[level] = !(sure > 2) ? -1 : softer < 1/softs[SOFTS - 1] ? softer : 0;
    }
}
/* The largest overlap over the radius of grains so many times softer: on the line between two measured. */
static double soft_overlap(const softening *s, double softer) {
    int k = 1;
    while (k + 1 < SOFTS && 1/softs[k] < softer) k++;
    return s->overlap[k - 1]*pow(s->overlap[k]/s->overlap[k - 1], log(softer*softs[k - 1])/log(softs[k - 1]/softs[k]));
}
static void soft_draw(const points *p, const softening *s, const char *title, const char *y_label, const char *file) {
    static sheet t;
    double most = 8;
    char text[64];
    int k;
    t.file = study_open(file);
    if (!t.file) return;
    for (k = 0; k < SOFTS; k++) if (s->change[k] == s->change[k]) most = fmax(most, 115*fabs(s->change[k]));
    most = fmin(most, 25);
    t.log_x = 1;
    t.log_y = 0;
    t.range[0] = -0.2; t.range[1] = log10(1/softs[SOFTS - 1]) + 0.3;
    t.range[2] = -most; t.range[3] = most;
    sheet_begin(&t, title, "how many times softer than the true grain (E = 1e9 Pa)", y_label, 150);
    sheet_band(&t, -5, 5, "#f2f2ee", 0);
    sheet_band(&t, -2, 2, "#e6e6df", 0);
    sheet_band(&t, -1, 1, "#d6d6cc", 0);
    for (k = 0; k < LEVELS; k++) {
        const double x = sheet_x(&t, s->passes[k]);
        snprintf(text, sizeof text, "+- %.0f %%", 100*soft_levels[k]);
        if (k || most < 12)
            study_text(t.file, t.left + t.w + 6, sheet_y(&t, 100*soft_levels[k]) + 4, "start", 12, 0, text);
        if (!(s->passes[k] > 0)) continue;
        study_stroke(t.file, STUDY_DASHED, points_inks[1]);
        fprintf(t.file, "M%.1f %.1fv%.1f\"/>\n", x, t.top + 20.0 + 18*k, t.h - 20 - 18*k);
        snprintf(text, sizeof text, "%.0f %%: E/%.0f", 100*soft_levels[k], s->passes[k]);
        study_text(t.file, x - 4, t.top + 32 + 18*k, "end", 13, 0, text);
    }
    study_stroke(t.file, STUDY_LINE, points_inks[0]);
    for (k = 0; k <= 30 && s->misfit == s->misfit; k++) { /* the fit, down to E/1000                             */
        const double softer = pow(10, 0.1*k);
        fprintf(t.file, "%c%.1f %.1f", k ? 'L' : 'M', sheet_x(&t, softer),
                sheet_y(&t, 100*(s->fit[0] + s->fit[1]*pow(softer, s->fit[2]))));
    }
    fputs("\"/>\n", t.file);
    for (k = 0; k < SOFTS; k++) {
        point q;
        memset(&q, 0, sizeof q);
        q.cost = 1/softs[k];
        q.error = 100*s->change[k];
        q.bar = 200*s->bar[k];
        if (!(fabs(q.error) < most)) continue;
        sheet_dot(&t, &q, points_inks[0], k && fabs(s->change[k]) < 2*s->bar[k]);
        if (k%2) continue;
        snprintf(text, sizeof text, "cost %.2g, overlap %.1g", s->cost[k], s->overlap[k]);
        study_text(t.file, sheet_x(&t, q.cost) + 4, t.top + t.h - 8 - (k%4 ? 16 : 0),
                   k == SOFTS - 2 ? "end" : "start", 11, 0, text);
    }
    study_text(t.file, t.left + 8, t.top + 16, "start", 12, 0, p->remark);
    sheet_end(&t, file);
}
static void soft_tell(points *p, const softening *s, const accuracy_files *files) {
    char name[96], text[128];
    int k;
    snprintf(name, sizeof name, "%s.csv", p->name);
    FILE *file = study_open(name);
    if (file) fprintf(file, "E_over_true,change,bar,cost,overlap\n");
    for (k = 0; k < SOFTS; k++) {
        if (file) fprintf(file, "%g,%.6g,%.3g,%.4g,%.4g\n", softs[k], s->change[k], s->bar[k], s->cost[k],
                          s->overlap[k]);
        snprintf(name, sizeof name, "%s.E%g.change", p->name, softs[k]);
        snprintf(text, sizeof text, "%+.2f +- %.2f", 100*s->change[k], 100*s->bar[k]);
        if (s->change[k] != s->change[k]) snprintf(text, sizeof text, "a run was stopped");
        study_result_text(name, text, s->change[k] == s->change[k] ? "%" : "");
        if (!files->softening) continue;
        if (s->change[k] == s->change[k]) fprintf(files->softening, "%s,%g,%.2f,%.2f,%.3f,%.3f\n", p->name, softs[k],
                                                  100*s->change[k], 100*s->bar[k], s->cost[k], s->overlap[k]);
        else fprintf(files->softening, "%s,%g,,,%.3f,%.3f\n", p->name, softs[k], s->cost[k], s->overlap[k]);
    }
    for (k = 0; k < LEVELS; k++) {
        snprintf(name, sizeof name, "%s.passes_%.0f_percent", p->name, 100*soft_levels[k]);
        if (s->passes[k] > 0) snprintf(text, sizeof text, "E/%.0f, overlap %.2g", s->passes[k],
                                        soft_overlap(s, s->passes[k]));
        else if (s->passes[k] < 0) snprintf(text, sizeof text, "no significant change");
        else snprintf(text, sizeof text, "not by E/%.0f", 1/softs[SOFTS - 1]);
        study_result_text(name, text, "");
        if (!(s->passes[k] > 0)) continue;
        snprintf(text, sizeof text, "softness at which the fit passes %.0f %%", 100*soft_levels[k]);
        points_number(p, text, s->passes[k], 0, "1", 0);
        snprintf(text, sizeof text, "largest overlap where the fit passes %.0f %%", 100*soft_levels[k]);
        points_number(p, text, soft_overlap(s, s->passes[k]), 0, "radii", 0);
    }
    snprintf(name, sizeof name, "%s.power", p->name);
    study_result(name, s->fit[2], "");
    points_number(p, "exponent of the fit over softness", s->fit[2], 0, "1", 0);
    points_number(p, "residuals of the fit", s->misfit, 0, "standard errors", 0);
    points_numbers_write(p, files->numbers);
    if (file) { snprintf(name, sizeof name, "%s.csv", p->name); study_close(file, name); }
}
/* Soft grains are cheap: they get more seeds. */
static void soft_measure(points *p, softening *s, scene_fn scene, int wanted, int what) {
    static outcome out[SOFTS][SCENE_SEEDS];
    int k, i, seeds[SOFTS], least = scene_seeds(wanted), total = 0, done = 0;
    double bar[SOFTS], mean[SOFTS], scatter[SOFTS], own[SOFTS], usual, unit[SCENE_SEEDS], spent[SCENE_SEEDS];
    for (k = 0; k < SOFTS; k++) {
        seeds[k] = softs[k] < 0.2 && !quick ? 2*least : least;
        total += seeds[k];
    }
    for (i = 0; i < SCENE_SEEDS; i++)
        for (k = quick ? 1 : 0; k < SOFTS; k++) {
            const choice c = {.soften = softs[k]};
            if (i >= seeds[k]) continue;
            study_progress(p->name, (double)done++/total, 0);
            out[k][i] = scene(&c, i + 1);
        }
    study_progress(p->name, 1, 0);
    if (quick) memcpy(out[0], out[1], sizeof out[0]); /* to try it out: against grains 10 times softer     */
    for (k = 0; k < SOFTS; k++) { /* scatter of one run, as usual: few seeds may agree by chance              */
        mean[k] = scene_mean(out[k], seeds[k], what, &bar[k]);
        scatter[k] = bar[k]*sqrt((double)seeds[k]);
    }
    usual = bench_median(scatter, SOFTS);
    for (k = 0; k < SOFTS; k++) {
        bar[k] = fmax(bar[k], usual/sqrt((double)seeds[k]));
        s->change[k] = mean[k]/mean[0] - 1;
        own[k] = bar[k]/fabs(mean[0]);
        s->bar[k] = k ? hypot(own[k], own[0]) : own[0];
        for (i = 0, s->overlap[k] = 0; i < seeds[k]; i++) s->overlap[k] = fmax(s->overlap[k], out[k][i].overlap);
        for (i = 0; i < least; i++) { unit[i] = out[0][i].seconds; spent[i] = out[k][i].seconds; }
        s->cost[k] = bench_median_ratio(spent, unit, least);
    }
    soft_fit(s, own);
    points_number(p, "true grain", mean[0], bar[0], p->unit, least);
    snprintf(p->remark, sizeof p->remark, "true grain: %.4g, %d seeds, %d of the softer ones; bars are two standard errors",
             mean[0], least, seeds[SOFTS - 1]);
}
#endif /* ACCURACY_STUDIES_H */
