/* accuracy.c - what accuracy costs: work-precision diagrams, error against processor time. MIT licence.

   build/accuracy                      all diagrams, some 30 minutes; build/out/accuracy receives page, pictures, CSV
   build/accuracy --list               prints their names
   build/accuracy --diagram hopper     one of them (or several: the names that begin so)
   build/accuracy --quick              coarse, for a trial

   A diagram is a row of the table below: a function that adds points {cost, error, bar, label}. Cost is processor time
   over that of the library's own setting; errors are against a converged run of our own, or an exact result. Where
   results scatter, several seeds are run, and errors below two standard errors count as equal. Efficient points are
   ringed and joined: no other setting is both as accurate and as cheap.

   Softening has diagrams of its own: the change of an observable when Young's modulus falls, and the softness at which
   the change passes 1, 2 and 5 %.

   The page (docs/accuracy.md, by bench/pages.sh) receives a list of the diagrams, their cheapest and most accurate
   efficient settings, and a summary of softening; docs/data receives accuracy_efficient.csv, accuracy_numbers.csv and
   accuracy_softening.csv.

   The same source compiled with other options (-DBENCH_VARIANT='"single"' -DDEM_REAL=float, or '"one_domain"' and
   -DDEM_DOMAIN_BODIES=100000000) runs the rows marked `variant` and writes points.csv in a separate folder; the
   ordinary program draws those points too if it finds them. */
#define DEM_IMPLEMENTATION
#include "dem.h"
#include "examples/study.h"
#include "bench/measure.h"
#include "bench/scenes.h"
#include "bench/accuracy_points.h"
#include "bench/accuracy_scenes.h"
#include "bench/accuracy_variants.h"
#include "bench/accuracy_impacts.h"
#include "bench/accuracy_beds.h"
#include "bench/accuracy_studies.h"

typedef struct row {
    const char *name, *title, *x_label, *y_label;
    void (*fill)(points *p);         /* work and precision; null: softening, by the next three fields       */
    scene_fn scene;
    int seeds, what;
    int variant;                     /* 1: other builds add points                                           */
    const char *unit;                /* of the observable                                                    */
    const char *about, *against;     /* for the page: scene and reference                                    */
} row;

#define COST "cost (the library's own setting = 1)"
#define IMPACT "cost of the impact (library's own: velocity Verlet, t_c/50 = 1)"
static const row rows[] = {
    {"restitution", "Head-on impact, restitution 0.66", IMPACT, "error of restitution", fill_restitution, 0, 0, 0,
     0, "1",
     "bead of 1.5 mm on a plane at 1 m/s (Hertz), root mean square over 16 instants of first contact",
     "restitution 0.66"},
    {"energy", "Head-on impact, elastic", IMPACT, "error of energy", fill_energy, 0, 0, 0, 0, "1",
     "the same impact with restitution 1",
     "energy before the impact"},
    {"oblique", "Oblique impacts: friction law and slider", IMPACT, "error of leaving velocity and spin",
     fill_oblique, 0, 0, 0, 0, "1",
     "aluminium oxide bead of 2.5 mm at 3.9 m/s, 5 to 60 degrees, e = 0.66, mu = 0.2",
     "converged result of each law"},
    {"oblique_mfix", "Oblique impacts of MFiX DEM05", IMPACT, "error of leaving velocity and spin",
     fill_oblique_mfix, 0, 0, 0, 0, "1",
     "the same bead, linear spring without damping, mu = 0.092",
     "converged result (dashed: published figures of MFiX)"},
    {"ball", "A ball that bounces for 10 s", COST, "largest change of height", fill_ball, 0, 0, 0, 1, "1",
     "MFiX DEM02: fall of 0.4 m, restitution 1, kn = 5e4 N/m",
     "first height"},
    {"top", "A free top after 10 s", "cost (SPIRAL at 0.01 s = 1)", "error of orientation, rad", fill_top, 0, 0, 0,
     1, "1",
     "principal moments 1, 2, 3 and spin (1, 1, 1)",
     "exact solution in Jacobi's elliptic functions"},
    {"gas_energy", "Elastic gas: energy", COST, "largest change of energy", fill_gas_energy, 0, 0, 0, 1, "1",
     "400 smooth spheres, 10 % solid, some 40 collisions each",
     "energy at the start"},
    {"gas_pressure", "Elastic gas: pressure", COST, "error of pressure", fill_gas_pressure, 0, 0, 0, 0, "1",
     "the same gas: p V/(N T) from the virial, sampled five times per contact",
     "t_c/200"},
    {"bed_stress", "Settled bed: force on the floor", COST, "error of the floor's force", fill_bed_stress, 0, 0, 0,
     0, "1",
     "399 spheres of three sizes in a periodic box six diameters wide, 0.8 s after their release",
     "weight of the spheres"},
    {"bed_porosity", "Settled bed: solid fraction", COST, "error of the solid fraction", fill_bed_porosity, 0, 0,
     0, 0, "1",
     "the same bed: solid fraction of a column with the same centre of mass",
     "t_c/100"},
    {"bed_energy", "Settled bed: kinetic energy left", COST, "kinetic energy over m g d of one ball",
     fill_bed_energy, 0, 0, 0, 0, "1",
     "the same bed",
     "0"},
    {"pile", "Pile on a shelf: slope", COST, "error of the slope", fill_pile, 0, 0, 0, 0, "degrees",
     "450 discs on a shelf, 1.2 s after its front is removed: slope of the triangle with the same centre of mass",
     "t_c/100"},
    {"slow", "Slow drum: angle of repose", COST, "error of the angle", fill_slow, 0, 0, 0, 0, "degrees",
     "210 discs in a drum with small bars, omega^2 R/g = 0.023: mean angle of the centre of mass",
     "t_c/100"},
    {"hopper", "Hopper: rate of discharge", COST, "error of the rate", fill_hopper, 0, 0, 0, 1, "grains/s",
     "480 discs, slot eight diameters wide, discharged fraction 0.15 to 0.8",
     "t_c/100"},
    {"mill", "Mill: power", COST, "error of the power", fill_mill, 0, 0, 0, 0, "W",
     "210 discs in a drum with eight bars at 70 % of the critical speed",
     "t_c/100"},
    {"sieve", "Shaken sieve: passed fraction", COST, "error of the fraction", fill_sieve, 0, 0, 0, 0, "1",
     "210 spheres with diameters of 0.5, 0.7 and 0.85 hole widths",
     "plate with square holes, t_c/100"},
    {"ellipsoids", "Elastic gas of ellipsoids: kinds of overlap", COST, "largest change of energy", fill_spheroids,
     0, 0, 0, 0, "1",
     "120 smooth ellipsoids 2 : 1 : 1, 5 % solid",
     "energy at the start"},
    {"clusters", "An ellipsoid made of spheres: rebound", "cost of a bed (the ellipsoid itself = 1)",
     "error of the leaving velocity", fill_cluster_rebound, 0, 0, 0, 0, "1",
     "n spheres inside an ellipsoid 2 : 1 : 1, with its mass and inertia, 16 tilts",
     "rigid ellipsoid"},
    {"cluster_packing", "An ellipsoid made of spheres: packing", "cost of a bed (the ellipsoid itself = 1)",
     "error of the solid fraction", fill_cluster_packing, 0, 0, 0, 0, "1",
     "60 of these bodies in a periodic box six widths wide",
     "ellipsoid, t_c/100"},
    {"skin", "Cost of skin and search", "skin over radius", "time of a step (library's choice = 1)", fill_skin, 0,
     0, 0, 0, "1",
     "18,000 beads in a drum",
     "skin chosen by the library"},
    {"soft_angle", "Softening: angle of repose of the slow drum", "", "change of the angle, %", 0, scene_slow, 4,
     1, 0, "degrees",
     "the slow drum above",
     "grain of 1e9 Pa"},
    {"soft_hopper", "Softening: rate of discharge of the hopper", "", "change of the rate, %", 0, scene_hopper, 7,
     0, 0, "grains/s",
     "the hopper above",
     "grain of 1e9 Pa"},
    {"soft_mill", "Softening: power of the mill", "", "change of the power, %", 0, scene_mill, 4, 0, 0, "W",
     "the mill above",
     "grain of 1e9 Pa"},
    {"soft_sizes", "Softening: segregation in a drum", "", "change of the segregation, %", 0, scene_sizes, 4, 2, 0,
     "1",
     "45 large discs and 180 of half the size, 2.5 to 5 s after the start: mean distance of the small ones from the "
     "centre of the charge over that of the large ones",
     "grain of 1e9 Pa"}};
enum { ROWS = (int)(sizeof rows/sizeof *rows) };

/* ---- the page: three tables, written after all diagrams ---- */

typedef struct summary {
    const row *of;                   /* null: the diagram was not made                                       */
    int efficient, cheap, best;      /* points; the cheapest and the most accurate of them                   */
    point cheap_point, best_point;
    const char *cheap_series, *best_series;
    softening soft;
    double overlap;                  /* radii, where the fit passes the first level                          */
} summary;
static summary summaries[ROWS];

static void summary_points(summary *y, const points *p) {
    int i, cheap = -1, best = -1;
    for (i = 0; i < p->count; i++) {
        if (!p->at[i].front) continue;
        y->efficient++;
        if (cheap < 0 || p->at[i].cost < p->at[cheap].cost) cheap = i;
        if (best < 0 || p->at[i].error < p->at[best].error) best = i;
    }
    y->cheap = cheap;
    y->best = best;
    if (cheap < 0) return;
    y->cheap_point = p->at[cheap];
    y->best_point = p->at[best];
    y->cheap_series = p->series[p->at[cheap].series];
    y->best_series = p->series[p->at[best].series];
}
static void summary_point(FILE *page, const char *series, const point *q) {
    fprintf(page, " %s, %s | %.2f | %.1e |", series, q->label, q->cost, q->error);
    if (q->bar > 0) fprintf(page, " %.1e |", q->bar); else fprintf(page, " |");
}
static void summaries_write(FILE *page) {
    int i, k;
    fprintf(page, "\n### Diagrams\n| diagram | name | vertical axis | scene | reference |\n|---|---|---|---|---|\n");
    for (i = 0; i < ROWS; i++) {
        const row *r = summaries[i].of;
        if (r) fprintf(page, "| [%s](images/accuracy_%s.png) | `%s` | %s | %s | %s |\n", r->title, r->name, r->name, r->y_label,
                       r->about, r->against);
    }
    fprintf(page, "\n### Efficient settings\n| diagram | cheapest setting | cost | error | standard error | most accurate "
            "setting | cost | error | standard error |\n|---|---|---|---|---|---|---|---|---|\n");
    for (i = 0; i < ROWS; i++) {
        const summary *y = &summaries[i];
        if (!y->of || !y->of->fill || y->of->fill == fill_skin || !y->efficient) continue;
        fprintf(page, "| `%s` |", y->of->name);
        summary_point(page, y->cheap_series, &y->cheap_point);
        if (y->best != y->cheap) summary_point(page, y->best_series, &y->best_point);
        else fprintf(page, " | | | |");
        fprintf(page, "\n");
    }
    fprintf(page, "\n### Softening\n| diagram | E over 1e9 Pa | change [%%] | standard error [%%] | cost [1e9 Pa = 1] | "
            "largest overlap [radii] |\n|---|---|---|---|---|---|\n");
    for (i = 0; i < ROWS; i++)
        for (k = 1; k < SOFTS && summaries[i].of && !summaries[i].of->fill; k++) {
            const softening *s = &summaries[i].soft;
            if ((softs[k] < 0.05 || softs[k] > 0.2) && (softs[k] < 0.005 || softs[k] > 0.02)) continue; /* a tenth, a hundredth */
            fprintf(page, "| `%s` | %g | %+.2f | %.2f | %.3f | %.3f |\n", summaries[i].of->name, softs[k], 100*s->change[k],
                    100*s->bar[k], s->cost[k], s->overlap[k]);
        }
    fprintf(page, "\n| diagram | softness for a change of 1 %% [1e9 Pa/E] | largest overlap there [radii] |\n|---|---|---|\n");
    for (i = 0; i < ROWS; i++)
        if (summaries[i].of && !summaries[i].of->fill && summaries[i].soft.passes[0] > 0)
            fprintf(page, "| `%s` | %.0f | %.2g |\n", summaries[i].of->name, summaries[i].soft.passes[0], summaries[i].overlap);
}

/* One diagram: points, picture, tables. */
static void row_run(const row *r, const accuracy_files *files) {
    static points p;
    static softening s;
    const double begun = cpu_clock();
    summary *y = &summaries[r - rows];
    char file[80];
    points_clear(&p, r->name);
    p.unit = r->unit;
    snprintf(file, sizeof file, "%s.svg", r->name);
    y->of = r;
    if (r->fill) {
        r->fill(&p);
        points_front(&p);
        summary_points(y, &p);
        if (!variant_name()) points_draw(&p, r->title, r->x_label, r->y_label, file);
        points_tell(&p, files);
    } else {
        soft_measure(&p, &s, r->scene, r->seeds, r->what);
        soft_draw(&p, &s, r->title, r->y_label, file);
        soft_tell(&p, &s, files);
        y->soft = s;
        if (s.passes[0] > 0) y->overlap = soft_overlap(&s, s.passes[0]);
    }
    snprintf(file, sizeof file, "%s.time", r->name);
    bench_result_short(file, cpu_clock() - begun, "s");
}
int main(int argc, char **argv) {
    static const char *out = "build/out/accuracy", *wanted = "";
    static int list;
    static const study_option table[] = {
        {"data", STUDY_TEXT, &data_folder, 0, 0, "", "folder of start states"},
        {"out", STUDY_TEXT, &out, 0, 0, "", "folder of results"},
        {"diagram", STUDY_TEXT, &wanted, 0, 0, "", "only those whose name begins with this"},
        {"list", STUDY_FLAG, &list, 0, 0, "", "print the names of all diagrams and stop"},
        {"quick", STUDY_FLAG, &quick, 0, 0, "", "coarse, for a trial"},
    };
    const double load = bench_load();
    const int single = sizeof(dem_real) < sizeof(double);
    accuracy_files files = {0, 0, 0};
    FILE *page;
    int i, done = 0;
    if (variant_name()) out = variant_folder(variant_name());
    study_options(argc, argv, "What accuracy costs: error against processor time.", table, CHOICES(table));
    for (i = 0; i < ROWS && list; i++) printf("%-16s %s\n", rows[i].name, rows[i].title);
    if (list) return 0;
    study_begin(out);
    bench_machine();
    variant_begin();
    page = variant_name() ? 0 : bench_page_open();
    if (page) bench_page_machine(page, load);
    if (page) accuracy_files_open(&files);
    variant_price(page);
    for (i = 0; i < ROWS; i++) {
        if (strncmp(rows[i].name, wanted, strlen(wanted)) || (variant_name() && !(rows[i].variant && single))) continue;
        row_run(&rows[i], &files);
        done++;
    }
    if (!done && !variant_name()) study_fail("no diagram's name begins with '%s'; --list names them", wanted);
    variant_end();
    if (page) summaries_write(page);
    if (page) study_close(page, "page.md");
    accuracy_files_close(&files);
    return study_end();
}
