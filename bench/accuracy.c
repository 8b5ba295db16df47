/* accuracy.c - what accuracy costs: work-precision diagrams, error against processor time. MIT licence.

   build/accuracy                      all diagrams, some 30 minutes; build/out/accuracy gets a page, pictures, CSV
   build/accuracy --list               their names
   build/accuracy --diagram hopper     one of them (or several: the names that begin so)
   build/accuracy --quick              coarse: to try it out

   A diagram is a row of the table below: a function that fills in points {cost, error, bar, label}. Cost is processor
   time over that of the library's own setting; errors are against a converged run of our own, or an exact answer. Of
   what depends on chance several seeds are run, and what lies below two standard errors counts as equal. Efficient
   points are ringed and joined: nothing else is as near and as cheap.

   Softening has diagrams of its own: by how much an observable changes when Young's modulus falls, and where that
   passes 1, 2 and 5 %.

   The same source compiled otherwise (-DBENCH_VARIANT='"single"' -DDEM_REAL=float, or '"one_domain"' and
   -DDEM_DOMAIN_BODIES=100000000) runs the rows that have a part in it and leaves points.csv in a folder of its own;
   the ordinary program draws those too when it finds them. */
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
    void (*fill)(points *p);         /* work and precision; null: softening, with the next three            */
    scene_fn scene;
    int seeds, what;
    int variant;                     /* 1: other builds have a part in it                                    */
    const char *about;               /* for the page                                                         */
} row;

#define COST "cost (the library's own setting = 1)"
#define IMPACT "cost of the impact (library's own: velocity Verlet, t_c/50 = 1)"
static const row rows[] = {
    {"restitution", "Head-on impact, restitution 0.66", IMPACT, "error of restitution", fill_restitution, 0, 0, 0, 0,
     "A bead of 1.5 mm meets a plane at 1 m/s (Hertz); root mean square over 16 instants of first touch in a step."},
    {"energy", "Head-on impact, elastic", IMPACT, "error of energy", fill_energy, 0, 0, 0, 0,
     "The same at restitution 1."},
    {"oblique", "Oblique impacts: friction law and slider", IMPACT, "error of leaving velocity and spin", fill_oblique,
     0, 0, 0, 0,
     "Aluminium oxide, 2.5 mm, 3.9 m/s, 5 to 60 degrees, e = 0.66, mu = 0.2; against each law's converged answer."},
    {"oblique_mfix", "Oblique impacts of MFiX DEM05", IMPACT, "error of leaving velocity and spin", fill_oblique_mfix,
     0, 0, 0, 0, "Linear spring without damping, mu = 0.092; dashed: the published figures of MFiX."},
    {"ball", "A ball that bounces for 10 s", COST, "largest change of height", fill_ball, 0, 0, 0, 1,
     "MFiX DEM02: falls 0.4 m, restitution 1, kn = 5e4 N/m."},
    {"top", "A free top after 10 s", "cost (SPIRAL at 0.01 s = 1)", "error of orientation, rad", fill_top, 0, 0, 0, 1,
     "Principal moments 1, 2, 3, spin (1, 1, 1); exact answer by Jacobi's elliptic functions."},
    {"gas_energy", "Elastic gas: energy", COST, "largest change of energy", fill_gas_energy, 0, 0, 0, 1,
     "400 smooth balls, 10 % solid, some 40 collisions each."},
    {"gas_pressure", "Elastic gas: pressure", COST, "error of pressure", fill_gas_pressure, 0, 0, 0, 0,
     "The same gas: p V/(N T) by the virial, sampled five times a contact."},
    {"bed_stress", "Settled bed: force on the floor", COST, "error of the floor's force", fill_bed_stress, 0, 0, 0, 0,
     "399 balls of three sizes fall into a periodic box of six diameters; 0.8 s later, against their weight, exactly."},
    {"bed_porosity", "Settled bed: solid fraction", COST, "error of the solid fraction", fill_bed_porosity, 0, 0, 0, 0,
     "The same bed: solid fraction of a column with the same centre of mass."},
    {"bed_energy", "Settled bed: kinetic energy left", COST, "kinetic energy over m g d of one ball", fill_bed_energy,
     0, 0, 0, 0, "The same bed."},
    {"pile", "Pile on a shelf: slope", COST, "error of the slope", fill_pile, 0, 0, 0, 0,
     "450 discs on a shelf whose front is taken away; slope of the triangle with the same centre of mass, 1.2 s "
     "later."},
    {"slow", "Slow drum: angle of repose", COST, "error of the angle", fill_slow, 0, 0, 0, 0,
     "210 discs in a drum with small bars, omega^2 R/g = 0.023; mean angle of the centre of mass."},
    {"hopper", "Hopper: rate of discharge", COST, "error of the rate", fill_hopper, 0, 0, 0, 1,
     "480 discs, a slot of eight diameters; while the share that is out rises from 0.15 to 0.8."},
    {"mill", "Mill: power", COST, "error of the power", fill_mill, 0, 0, 0, 0,
     "210 discs in a drum with eight bars at 70 % of critical speed."},
    {"sieve", "Shaken sieve: share that is through", COST, "error of the share", fill_sieve, 0, 0, 0, 0,
     "210 balls of 0.5, 0.7 and 0.85 holes; against the plate with square holes. Balls that are through cost less."},
    {"ellipsoids", "Elastic gas of ellipsoids: what counts as overlap", COST, "largest change of energy",
     fill_spheroids, 0, 0, 0, 0, "120 ellipsoids 2 : 1 : 1, smooth, 5 % solid."},
    {"clusters", "An ellipsoid made of spheres: rebound", "cost of a bed (the ellipsoid itself = 1)",
     "error of the leaving velocity", fill_cluster_rebound, 0, 0, 0, 0,
     "n spheres inside an ellipsoid 2 : 1 : 1, with its mass; 16 tilts, against a rigid ellipsoid."},
    {"cluster_packing", "An ellipsoid made of spheres: packing", "cost of a bed (the ellipsoid itself = 1)",
     "error of the solid fraction", fill_cluster_packing, 0, 0, 0, 0, "60 of them fall into a box of six widths."},
    {"skin", "Skin and search: what they cost", "skin over radius", "time of a step (library's choice = 1)", fill_skin,
     0, 0, 0, 0, "18,000 beads in a drum: the same contacts whatever the skin."},
    {"soft_angle", "Softening: angle of repose of the slow drum", "", "change of the angle, %", 0, scene_slow, 4, 1, 0,
     "The slow drum above."},
    {"soft_hopper", "Softening: rate of discharge of the hopper", "", "change of the rate, %", 0, scene_hopper, 7, 0, 0,
     "The hopper above."},
    {"soft_mill", "Softening: power of the mill", "", "change of the power, %", 0, scene_mill, 4, 0, 0,
     "The mill above."},
    {"soft_sizes", "Softening: segregation in a drum", "", "change of the segregation, %", 0, scene_sizes, 4, 2, 0,
     "45 large discs and 180 of half the size, 2.5 to 5 s after the start; mean distance of small ones from the middle "
     "of the charge over that of large ones."}};
enum { ROWS = (int)(sizeof rows/sizeof *rows) };

/* One diagram: points, picture, table. */
static void row_run(const row *r, FILE *page) {
    static points p;
    static softening s;
    const double begun = cpu_clock();
    char file[80];
    points_clear(&p, r->name);
    snprintf(file, sizeof file, "%s.svg", r->name);
    if (page) fprintf(page, "\n### %s\n`--diagram %s` %s\n\n![](images/accuracy_%s.png)\n\n", r->title, r->name,
                      r->about, r->name);
    if (r->fill) {
        r->fill(&p);
        points_front(&p);
        if (!variant_name()) points_draw(&p, r->title, r->x_label, r->y_label, file);
        points_tell(&p, page);
    } else {
        soft_measure(&p, &s, r->scene, r->seeds, r->what);
        soft_draw(&p, &s, r->title, r->y_label, file);
        soft_tell(&p, &s, page);
    }
    snprintf(file, sizeof file, "%s.time", r->name);
    bench_result_short(file, cpu_clock() - begun, "s");
}
int main(int argc, char **argv) {
    static const char *out = "build/out/accuracy", *wanted = "";
    static int list;
    static const study_option table[] = {
        {"data", STUDY_TEXT, &data_folder, 0, 0, "", "where the start states are"},
        {"out", STUDY_TEXT, &out, 0, 0, "", "folder of results"},
        {"diagram", STUDY_TEXT, &wanted, 0, 0, "", "only those whose name begins so"},
        {"list", STUDY_FLAG, &list, 0, 0, "", "names of all diagrams, and stop"},
        {"quick", STUDY_FLAG, &quick, 0, 0, "", "coarse, to try it out"},
    };
    const double load = bench_load();
    const int single = sizeof(dem_real) < sizeof(double);
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
    variant_price(page);
    for (i = 0; i < ROWS; i++) {
        if (strncmp(rows[i].name, wanted, strlen(wanted)) || (variant_name() && !(rows[i].variant && single))) continue;
        row_run(&rows[i], page);
        done++;
    }
    if (!done && !variant_name()) study_fail("no diagram's name begins with '%s'; --list names them", wanted);
    variant_end();
    if (page) study_close(page, "page.md");
    return study_end();
}
