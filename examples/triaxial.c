/* triaxial.c - triaxial compression of spheres in a periodic cell: isotropic compression to a pressure, then axial strain while
   the lateral stress stays; friction angle and volume over axial strain, of a dense and a loose sample.
   Build: cc -O2 -I. -o triaxial examples/triaxial.c dem.c -lm          Run: ./triaxial [--out build/out/triaxial]

   The dense sample is compressed without friction, the loose one with that of the test. sin(angle) = (s1 - s3)/(s1 + s3).
   The critical angle is the mean over the last third of the strain. Beside it: the angle that shear.c finds for the critical
   state of simple shear, by the criterion of Matsuoka & Nakai. The peak of the dense sample follows from the critical angle
   and the dilatancy by Rowe, Proc. R. Soc. A 269:500 (1962): s1/s3 = (1 - dV/da) (1 + sin c)/(1 - sin c) with volume strain V
   (> 0: compression), axial strain a and critical angle c. */
#include "dem.h"
#include "study.h"
#include "sample.h"

enum { POINTS = 200 };
static const double PRESSURE = 1e4, FASTEST = 50, DEGREE = 57.29577951308232;              /* Pa; 1/s */
static double friction = 0.5, young = 1e8, most = 0.4, inertial = 2e-3;
static int grains = 800, brief;
static const char *out = "build/out/triaxial";

/* Friction of all contacts from now on */
static void rub(dem_world *world, dem_material m, double mu) {
    dem_pair p;
    if (dem_pair_get(world, m, m, &p) != DEM_OK) study_fail("%s", dem_world_error_get(world));
    p.friction = p.friction_static = (dem_real)mu;
    if (dem_pair_set(world, m, m, &p) != DEM_OK) study_fail("%s", dem_world_error_get(world));
}
/* One test; strain, angle and volume strain (%, degrees, %) at POINTS points. Returns the largest error of the lateral stress. */
static double test(int dense, double *strain, double *angle, double *volume) {
    const double rate = inertial/(SAMPLE_D*sqrt(SAMPLE_DENSITY/PRESSURE)), P = PRESSURE;
    const dem_real p = (dem_real)P, fast = (dem_real)FASTEST;
    const dem_cell_desc squeeze = {.stress = {p, p, p}, .rate_most = {fast, fast, fast}};
    const dem_cell_desc load = {.rate = {0, 0, (dem_real)-rate}, .stress = {p, p, 0}, .rate_most = {fast, fast, 0}};
    const char *name = dense ? "dense" : "loose";
    double worst = 0, start, before; dem_material m;
    dem_world *world = sample_make(grains, young, friction, 0, &m);
    dem_stress s; dem_cell_state c;
    rub(world, m, dense ? 0 : friction);
    sample_run(world, &squeeze, 6/FASTEST);
    rub(world, m, friction);
    sample_run(world, 0, brief ? 0.002 : 0.02);
    if (study.failures || dem_stress_get(world, &s) != DEM_OK || dem_cell_state_get(world, &c) != DEM_OK) return 1;
    study_say("%s: solid fraction %.4f, %.2f contacts per grain, stress %.0f %.0f %.0f Pa", name, s.solid, s.coordination, s.total[0], s.total[1], s.total[2]);
    study_result(dense ? "solid_dense" : "solid_loose", s.solid, "after isotropic compression");
    start = c.strain[2];
    before = c.strain[0] + c.strain[1] + c.strain[2];
    for (int n = 0; n < POINTS && !study.failures; n++) {
        double lateral = 0, axial = 0;
        for (int k = 0; k < 10; k++) {                      /* each point: mean of ten samples */
            sample_run(world, n + k ? 0 : &load, most/POINTS/10/rate);
            if (study.failures || dem_stress_get(world, &s) != DEM_OK) return 1;
            axial += s.total[2]/10;
            lateral += (s.total[0] + s.total[1])/20;
        }
        dem_cell_state_get(world, &c);
        if (n > POINTS/100) worst = fmax(worst, fabs(lateral/P - 1));
        strain[n] = 100*(start - c.strain[2]);
        angle[n] = DEGREE*asin((axial - lateral)/(axial + lateral));
        volume[n] = 100*(before - c.strain[0] - c.strain[1] - c.strain[2]);
        study_progress(name, (n + 1.0)/POINTS, grains*(double)dem_world_steps_get(world));
    }
    dem_world_destroy(world);
    return worst;
}
int main(int argc, char **argv) {
    static const study_option table[] = {
        {"grains", STUDY_INT, &grains, 100, 1e5, "", "number of spheres"},
        {"friction", STUDY_REAL, &friction, 0, 10, "", "friction between spheres"},
        {"young", STUDY_REAL, &young, 1e6, 1e11, "Pa", "Young's modulus; the pressure is 10 kPa"},
        {"strain", STUDY_REAL, &most, 0.01, 1, "", "largest axial strain"},
        {"inertial", STUDY_REAL, &inertial, 1e-5, 0.1, "", "inertial number of the axial strain"},
        {"short", STUDY_FLAG, &brief, 0, 0, "", STUDY_SHORT}, {"out", STUDY_TEXT, &out, 0, 0, "", "folder of results"}};
    double strain[2][POINTS], angle[2][POINTS], volume[2][POINTS], critical[2] = {0, 0}, peak = 0, rowe = 0, worst = 0;
    study_figure f = {.title = "Triaxial compression", .x_label = "axial strain (%)", .y_label = "mobilised friction angle (degrees)"};
    study_figure g = {.title = "Triaxial compression", .x_label = "axial strain (%)", .y_label = "volume strain (%), > 0: denser"};
    study_options(argc, argv, "Triaxial compression of a dense and a loose sample of spheres in a periodic cell.", table, 7);
    if (brief) { grains = 150; young = 1e7; most = 0.1; inertial = 0.01; }
    study_begin(out);
    for (int k = 0; k < 2; k++) {
        worst = fmax(worst, test(!k, strain[k], angle[k], volume[k]));
        for (int n = 2*POINTS/3; n < POINTS; n++) critical[k] += angle[k][n]/(POINTS - 2*POINTS/3);
        study_curve(&f, k ? "loose" : "dense", k ? STUDY_DASHED : STUDY_LINE, POINTS, strain[k], angle[k]);
        study_curve(&g, k ? "loose" : "dense", k ? STUDY_DASHED : STUDY_LINE, POINTS, strain[k], volume[k]);
    }
    if (study.failures) return study_end();
    const double sine = sin((critical[0] + critical[1])/2/DEGREE), K = (1 + sine)/(1 - sine);
    for (int n = 5; n + 5 < POINTS; n++) {                 /* dilatancy over ten points; stress over as many */
        const double D = 1 - (volume[0][n + 5] - volume[0][n - 5])/(strain[0][n + 5] - strain[0][n - 5]);
        rowe = fmax(rowe, DEGREE*asin((K*D - 1)/(K*D + 1)));
        peak = fmax(peak, (angle[0][n - 2] + angle[0][n - 1] + angle[0][n] + angle[0][n + 1] + angle[0][n + 2])/5);
    }
    study_figure_write(&f, "angle.svg"); study_figure_write(&g, "volume.svg");
    study_csv("triaxial.csv", "strain_dense,angle_dense,volume_dense,strain_loose,angle_loose,volume_loose", POINTS, 6,
              (const double *const[]){strain[0], angle[0], volume[0], strain[1], angle[1], volume[1]});
    study_result("angle_peak", peak, "degrees, dense"); study_result("angle_rowe", rowe, "degrees, peak by dilatancy");
    study_result("critical_dense", critical[0], "degrees"); study_result("critical_loose", critical[1], "degrees");
    study_result("lateral_error", 100*worst, "% at most");
    return study_end();
}
