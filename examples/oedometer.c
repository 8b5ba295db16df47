/* oedometer.c - uniaxial compression of a bed by a servo wall: stress over strain, and the stiffness in small unloadings
   beside the effective medium of spheres with Hertz-Mindlin contacts.
   Build: cc -O2 -I. -o oedometer examples/oedometer.c dem.c -lm       Run: ./oedometer [--out build/out/oedometer]

   The sides are periodic: an oedometer without wall friction. The lid follows a table of stresses. It loads to a level,
   waits, unloads by 5 %, waits, loads again and goes on to the next level; at last it unloads to the first one. The
   stiffness at a level is the change of stress over the change of strain in its small unloading.
   Walton, J. Mech. Phys. Solids 35:213 (1987), derives the moduli of a random packing of solid fraction s with Z contacts
   per grain at the pressure P, for grains that move with the mean strain; all grow as P^(1/3). Grains that move freely make
   the packing softer, above all in shear: Makse et al., Phys. Rev. Lett. 83:5070 (1999). */
#include "dem.h"
#include "study.h"

enum { LEVELS = 7, ROWS = 5*LEVELS + 2, SAMPLES = 209, GRAINS = 600 };
static const double W = 0.014, YOUNG = 1e8, POISSON = 0.25, EVERY = 2.5e-3;                  /* m, Pa, -, s */
static dem_motion_row rows[ROWS];
static int row_count;
static const char *out = "build/out/oedometer";

static void go(double seconds, double stress) {                     /* one more row of the table */
    rows[row_count].time = row_count ? rows[row_count - 1].time + seconds : 0;
    rows[row_count++].load = (dem_real)stress;
}
static int sample_of(int row) { return (int)(rows[row].time/EVERY + 0.5); }
/* Modulus of uniaxial strain of the effective medium, K + 4/3 G, Pa */
static double medium(double P, double Z, double s) {
    const double q = Z*s*YOUNG/(2*(1 + POISSON)*3.14159265358979*(1 - POISSON)), x = q*q*P;
    return cbrt(x/18) + 4/3.0*(5 - 4*POISSON)/(5*(2 - POISSON))*cbrt(1.5*x);
}
static void plot(const char *file, const char *title, const char *x_label, const char *y_label, int n, const double *x,
                 const double *y, const double *z) {
    study_figure f = {.title = title, .x_label = x_label, .y_label = y_label, .log_x = !!z, .log_y = !!z};
    study_curve(&f, z ? "measured" : 0, z ? STUDY_DOTS : STUDY_LINE, n, x, y);
    if (z) { study_curve(&f, "effective medium", STUDY_LINE, n, x, z); f.x0 = 0.5; f.x1 = 100; f.y0 = 0.5; f.y1 = 10; }
    study_figure_write(&f, file);
}
int main(int argc, char **argv) {
    static const double level[LEVELS] = {1e3, 2e3, 5e3, 1e4, 2e4, 5e4, 1e5};                 /* Pa */
    static const study_option table[] = {{"out", STUDY_TEXT, &out, 0, 0, "", "folder of results"}};
    double strain[SAMPLES], stress[SAMPLES], mean[LEVELS], measured[LEVELS], theory[LEVELS];   /* %, kPa; kPa, MPa, MPa */
    double height = 0, worst = 0;
    study_options(argc, argv, "An oedometer whose lid follows a table of stresses.", table, 1);
    study_begin(out);
    const dem_real w = (dem_real)W;
    dem_world_desc desc = {.gravity = {0, 0, DEM_R(-9.81)}, .domain = {{0, 0, -1}, {w, w, 1}}, .impact_speed = DEM_R(0.1),
                           .boundary = {DEM_BOUNDARY_PERIODIC, DEM_BOUNDARY_PERIODIC}};
    dem_world *world = dem_world_create(&desc);
    const dem_material_desc stuff = {.density = 2500, .young = (dem_real)YOUNG, .poisson = (dem_real)POISSON,
                                     .restitution = DEM_R(0.5), .friction = DEM_R(0.3)};
    const dem_material glass = dem_material_add(world, &stuff);
    const dem_sizes sizes = {.min = DEM_R(0.9e-3), .max = DEM_R(1.1e-3)};
    dem_wall_plane_add(world, glass, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
    dem_sizes_fill(world, glass, &sizes, dem_region_make(dem_box_make(0, 0, 0, w, w, DEM_R(2e-8)*GRAINS/(w*w))), GRAINS, 1);
    if (dem_world_settle(world, 2, 0, 0, 0) != DEM_OK) study_fail("%s", dem_world_error_get(world));
    const double start = dem_world_time_get(world);
    const dem_bodies b = dem_bodies_get(world);
    for (int i = 0; i < b.count; i++) height = fmax(height, (double)(b.positions[4*i + 2] + b.positions[4*i + 3]));
    const dem_field_desc inside = {.box = {{0, 0, (dem_real)(0.2*height)}, {w, w, (dem_real)(0.8*height)}}, .cells = {1, 1, 1}, .stress = 1};
    const dem_field field = dem_field_add(world, &inside);

    go(0, level[0]);
    for (int k = 0; k < LEVELS; k++) {
        go(0.02, level[k]); go(0.02, level[k]); go(0.005, 0.95*level[k]); go(0.01, 0.95*level[k]); go(0.005, level[k]);
    }
    go(0.1, level[0]);
    const dem_wall lid = dem_wall_plane_add(world, glass, dem_vec3_make(0, 0, (dem_real)height), dem_vec3_make(0, 0, -1));
    const dem_motion press = {.kind = DEM_MOTION_SERVO, .velocity = {0, 0, DEM_R(-0.1)},     /* down, at most 0.1 m/s */
                              .area = w*w, .table = rows, .table_count = row_count};         /* loads are in Pa */
    if (dem_wall_motion_set(world, lid, &press) != DEM_OK) study_fail("%s", dem_world_error_get(world));
    for (int n = 0, k = 0; n < SAMPLES && !study.failures; n++) {
        dem_servo servo;
        if (dem_world_run_to(world, start + n*EVERY, 0, 0) != DEM_OK) study_fail("%s", dem_world_error_get(world));
        dem_wall_servo_get(world, lid, &servo);
        strain[n] = 100*servo.travel/height;
        stress[n] = 1e-3*servo.force/(W*W);
        if (servo.target > 0.05*level[LEVELS - 1]*W*W) worst = fmax(worst, fabs(servo.force/servo.target - 1));
        study_progress("oedometer", (n + 1.0)/SAMPLES, GRAINS*(double)dem_world_steps_get(world));
        if (k < LEVELS && n == sample_of(5*k + 1)) dem_field_reset(world, field);   /* the pause at a level begins */
        if (k == LEVELS || n != sample_of(5*k + 4)) continue;                       /* after the small unloading */
        const int was = sample_of(5*k + 2);
        dem_field_cell cell;
        dem_field_cell_get(world, field, 0, 0, 0, &cell);
        mean[k] = 1e-3*(cell.stress[0] + cell.stress[1] + cell.stress[2])/3;
        measured[k] = 0.1*(stress[was] - stress[n])/(strain[was] - strain[n])*(1 - 0.01*strain[n]);
        theory[k] = 1e-6*medium(1e3*mean[k], cell.coordination, cell.solid);
        k++;
    }
    dem_world_destroy(world);
    if (study.failures) return study_end();
    plot("path.svg", "Oedometer: loading with small unloadings, and unloading", "strain (%)", "stress (kPa)", SAMPLES, strain, stress, 0);
    plot("stiffness.svg", "Stiffness in small unloadings", "mean stress (kPa)", "modulus of uniaxial strain (MPa)", LEVELS, mean, measured, theory);
    study_result("load_error", 100*worst, "% at most, above 5 % of the largest load");
    study_result("strain_largest", strain[sample_of(5*LEVELS)], "%");
    study_result("strain_left", strain[SAMPLES - 1], "%");
    study_result("modulus", measured[LEVELS - 1], "MPa at the largest load");
    study_result("medium", theory[LEVELS - 1], "MPa, effective medium");
    study_result("exponent", log(measured[LEVELS - 1]/measured[3])/log(mean[LEVELS - 1]/mean[3]), "of modulus over mean stress, 7 to 66 kPa");
    return study_end();
}
