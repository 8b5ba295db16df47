/* shear.c - simple shear of spheres in a periodic cell at constant normal stress: friction mu = shear stress/pressure over the
   inertial number I = rate d sqrt(density/pressure), and a flow between two walls, whose stress is that of its grains. The
   pressure is the mean of the three normal stresses.
   Build: cc -O2 -I. -o shear examples/shear.c dem.c -lm          Run: ./shear [--out build/out/shear]

   Images across the y faces move with the shear (Lees & Edwards, J. Phys. C 5:1921 (1972)), and the height of the cell follows
   the stress along y. One sample runs through all I, the largest first. Beside it: mu = mu_s + (mu_2 - mu_s)/(1 + I0/I) with
   mu_s 0.382, mu_2 0.643, I0 0.279, for glass beads (Jop, Forterre & Pouliquen, Nature 441:727 (2006)), and the fit of Chialvo,
   Sun & Sundaresan, Phys. Rev. E 85:021305 (2012), to sheared periodic cells of spheres with a friction of 0.5,
   0.382 + 0.37/(1 + (0.32/I)^1.5). */
#include "dem.h"
#include "study.h"
#include "sample.h"

enum { MOST = 12 };
static const double PRESSURE = 1000;                                                        /* Pa */
static double friction = 0.5, strain = 4, young = 1e7, slowest = 0.03, fastest = 0.3;
static int grains = 500, brief;
static const char *out = "build/out/shear";

static double jop(double I) { return 0.382 + (0.643 - 0.382)/(1 + 0.279/I); }
static double chialvo(double I) { return 0.382 + 0.37/(1 + pow(0.32/I, 1.5)); }
/* Friction angle, degrees, in triaxial compression with the I1 I2/I3 of this stress (Matsuoka & Nakai, Proc. JSCE 232:59 (1974)) */
static double compression(const double mean[5]) {
    const double xx = 3*mean[2] - mean[1] - mean[4], minor = xx*mean[1] - mean[0]*mean[0];
    const double K = 3*mean[2]*(minor + mean[4]*(xx + mean[1]))/(mean[4]*minor), R = (K - 5 + sqrt((K - 5)*(K - 5) - 16))/4;
    return 57.29577951308232*asin((R - 1)/(R + 1));
}
/* Shear rate, 1/s, of an inertial number */
static double rate_of(double I) { return I/(SAMPLE_D*sqrt(SAMPLE_DENSITY/PRESSURE)); }

/* Shear between walls: the lower one moves along x, the upper one is led to the pressure. */
static void between_walls(void) {
    dem_material m;
    dem_world *world = sample_make(grains, young, 2*friction, 1, &m);
    const dem_box box = dem_world_desc_get(world).domain;
    const double top = (double)box.hi.y, area = (double)(box.hi.x*box.hi.z), rate = rate_of(0.05);
    const dem_motion slide = {.kind = DEM_MOTION_TRANSLATING, .velocity = {(dem_real)(-0.5*rate*top), 0, 0}};
    const dem_motion press = {.kind = DEM_MOTION_SERVO, .velocity = {0, DEM_R(-1.0), 0}, .load = (dem_real)(PRESSURE*area)};
    const dem_wall low = {1}, high = {2};
    double mean[5], over, by_walls[2];
    dem_wall_loads a, b; dem_servo servo;
    dem_wall_motion_set(world, low, &slide); dem_wall_motion_set(world, high, &press);
    sample_run(world, 0, fmax(strain/2, 1)/rate);
    dem_wall_loads_reset(world, low); dem_wall_loads_reset(world, high);
    sample_average(world, strain/rate, mean);
    dem_wall_servo_get(world, high, &servo);
    dem_wall_loads_get(world, low, &a);
    dem_wall_loads_get(world, high, &b);
    over = top/(top - servo.travel);                        /* dem_stress_get divides by the whole domain */
    for (int k = 0; k < 2; k++) {
        by_walls[k] = (k ? b.impulse[k] - a.impulse[k] : a.impulse[k] - b.impulse[k])/2/a.time/area;
        study_result(k ? "pressure_walls" : "shear_walls", by_walls[k], "Pa");
        study_result(k ? "pressure_grains" : "shear_grains", mean[k]*over, "Pa");
        study_result(k ? "pressure_difference" : "shear_difference", 100*(mean[k]*over/by_walls[k] - 1), "%");
    }
    dem_world_destroy(world);
}
int main(int argc, char **argv) {
    static const study_option table[] = {
        {"grains", STUDY_INT, &grains, 50, 1e5, "", "number of spheres"},
        {"friction", STUDY_REAL, &friction, 0, 10, "", "friction between spheres"},
        {"young", STUDY_REAL, &young, 1e6, 1e10, "Pa", "Young's modulus; the pressure is 1 kPa"},
        {"strain", STUDY_REAL, &strain, 0.2, 1000, "", "shear strain over which each point is averaged, after half of it"},
        {"slowest", STUDY_REAL, &slowest, 1e-4, 1, "", "smallest inertial number"},
        {"short", STUDY_FLAG, &brief, 0, 0, "", STUDY_SHORT}, {"out", STUDY_TEXT, &out, 0, 0, "", "folder of results"}};
    double I[MOST], mu[MOST], error[MOST], solid[MOST], one[MOST], two[MOST], mean[5], worst = 0;
    dem_material m;
    int n = 0;
    study_options(argc, argv, "Simple shear of spheres in a periodic cell at constant pressure: mu(I).", table, 7);
    if (brief) { grains = 150; strain = 0.5; slowest = 0.09; young = 1e6; }
    study_begin(out);
    dem_world *world = sample_make(grains, young, friction, 0, &m);
    for (double wish = fastest; wish > 0.99*slowest && n < MOST && !study.failures; wish /= sqrt(sqrt(10)), n++) {
        const double rate = rate_of(wish);
        const dem_cell_desc d = {.shear = (dem_real)rate, .stress = {0, (dem_real)PRESSURE, 0}, .rate_most = {0, 1000, 0}};
        sample_run(world, &d, (n ? 0.5 : 1)*fmax(strain, 1)/rate);
        error[n] = sample_average(world, strain/rate, mean);
        I[n] = wish*sqrt(PRESSURE/mean[2]); mu[n] = mean[0]/mean[2]; solid[n] = mean[3];
        one[n] = jop(I[n]); two[n] = chialvo(I[n]);
        worst = fmax(worst, fabs(mu[n] - two[n]));
        study_say("I %.4f: mu %.4f +- %.4f, solid fraction %.4f; beads %.4f, fit for spheres %.4f", I[n], mu[n], error[n], solid[n], one[n], two[n]);
    }
    dem_world_destroy(world);
    study_result("compression", compression(mean), "degrees, in triaxial compression, from the last stress");
    if (!study.failures) between_walls();
    if (study.failures) return study_end();
    study_figure f = {.title = "Simple shear at constant pressure", .x_label = "inertial number", .y_label = "shear stress / pressure", .log_x = 1};
    study_curve(&f, "dem.h", STUDY_DOTS, n, I, mu);
    study_curve(&f, "glass beads (Jop et al. 2006)", STUDY_LINE, n, I, one);
    study_curve(&f, "fit for spheres (Chialvo et al. 2012)", STUDY_DASHED, n, I, two);
    study_figure_write(&f, "mu.svg");
    study_csv("mu.csv", "I,mu,error,solid,beads,spheres", n, 6, (const double *const[]){I, mu, error, solid, one, two});
    study_result("mu_slowest", mu[n - 1], "at the smallest inertial number");
    study_result("solid_slowest", solid[n - 1], "solid fraction there");
    study_result("mu_deviation", worst, "at most, from the fit for spheres");
    return study_end();
}
