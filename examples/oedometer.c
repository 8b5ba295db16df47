/* oedometer.c - uniaxial compression of a sample by a servo wall: stress over strain, and the stiffness in small unloadings
   beside the effective medium of spheres with Hertz-Mindlin contacts.
   Build: cc -O2 -I. -o oedometer examples/oedometer.c dem.c -lm       Run: ./oedometer [--out build/out/oedometer]

   The sides are periodic: an oedometer without wall friction, and without gravity. The lid follows a table of stresses. It
   loads to a level, waits, unloads by 5 %, waits, loads again and goes on to the next level; at last it unloads to the first
   one. The stiffness at a level is the change of stress over the change of strain in its small unloading.
   Walton, J. Mech. Phys. Solids 35:213 (1987), derives the moduli of a random packing of solid fraction s with Z contacts
   per grain at the pressure P, for grains that move with the mean strain; all grow as P^(1/3). Grains that move freely make
   the packing softer, above all in shear: Makse et al., Phys. Rev. Lett. 83:5070 (1999). */
#include "dem.h"
#include "study.h"
#include "sample.h"

enum { LEVELS = 7, ROWS = 5*LEVELS + 2, PARTS = 6, SAMPLES = (ROWS - 2)*PARTS };
static const double YOUNG = 1e8, POISSON = 0.3, level[LEVELS] = {1e3, 2e3, 5e3, 1e4, 2e4, 5e4, 1e5};    /* Pa, -, Pa */

/* Modulus of uniaxial strain of the effective medium, K + 4/3 G, Pa */
static double medium(double P, double Z, double s) {
    const double q = Z*s*YOUNG/(2*(1 + POISSON)*SAMPLE_PI*(1 - POISSON)), x = q*q*P;
    return cbrt(x/18) + 4/3.0*(5 - 4*POISSON)/(5*(2 - POISSON))*cbrt(1.5*x);
}
int main(int argc, char **argv) {
    static const double seconds[5] = {0.02, 0.02, 0.005, 0.01, 0.005}, share[5] = {1, 1, 0.95, 0.95, 1};
    double strain[SAMPLES], stress[SAMPLES], mean[LEVELS], measured[LEVELS], theory[LEVELS], worst = 0;     /* %, kPa; kPa, MPa, MPa */
    dem_motion_row rows[ROWS] = {{0}};
    const char *out = "build/out/oedometer";
    const study_option table[] = {{"out", STUDY_TEXT, &out, 0, 0, "", "folder of results"}};
    study_options(argc, argv, "An oedometer whose lid follows a table of stresses.", table, 1);
    study_begin(out);
    dem_material glass;
    dem_world *world = sample_make(600, YOUNG, 0.3, 1, &glass);
    const dem_vec3 box = dem_world_desc_get(world).domain.hi;
    const dem_wall lid = {2};                                       /* the upper one */
    rows[0].load = (dem_real)level[0];                              /* in the first 0.2 s the lid moves until the grains bear it */
    for (int r = 1; r < ROWS; r++) {
        rows[r].time = rows[r - 1].time + (r == 1 ? 0.2 : r == ROWS - 1 ? 0.1 : seconds[(r - 1)%5]);
        rows[r].load = (dem_real)(r == ROWS - 1 ? level[0] : share[(r - 1)%5]*level[(r - 1)/5]);
    }
    const dem_motion press = {.kind = DEM_MOTION_SERVO, .velocity = {0, DEM_R(-0.1), 0},    /* down, at most 0.1 m/s */
                              .area = box.x*box.z, .table = rows, .table_count = ROWS};     /* loads are in Pa */
    if (dem_wall_motion_set(world, lid, &press) != DEM_OK) study_fail("%s", dem_world_error_get(world));
    dem_servo servo;
    sample_run(world, 0, 0.2);
    dem_wall_servo_get(world, lid, &servo);
    const double gone = servo.travel, height = (double)box.y - gone, area = (double)press.area;
    const dem_field_desc inside = {.box = {{0, (dem_real)(0.2*height), 0}, {box.x, (dem_real)(0.8*height), box.z}}, .cells = {1, 1, 1}, .stress = 1};
    const dem_field field = dem_field_add(world, &inside);
    for (int r = 2, n = 0; r < ROWS && !study.failures; r++) {
        for (int i = 0; i < PARTS; i++, n++) {
            sample_run(world, 0, (rows[r].time - rows[r - 1].time)/PARTS);
            dem_wall_servo_get(world, lid, &servo);
            strain[n] = 100*(servo.travel - gone)/height, stress[n] = 1e-3*servo.force/area;
            if (servo.target > 0.05*level[LEVELS - 1]*area) worst = fmax(worst, fabs(servo.force/servo.target - 1));
        }
        const int k = r/5, was = n - 1 - 2*PARTS;                   /* was: the end of the pause before the unloading */
        study_progress("oedometer", (r + 1.0)/ROWS, 0);
        if (r%5 == 1) dem_field_reset(world, field);                /* the pause at a level begins */
        if (r%5 != 4) continue;                                     /* after the small unloading */
        dem_field_cell cell;
        dem_field_cell_get(world, field, 0, 0, 0, &cell);
        mean[k] = 1e-3*(cell.stress[0] + cell.stress[1] + cell.stress[2])/3;
        measured[k] = 0.1*(stress[was] - stress[n - 1])/(strain[was] - strain[n - 1])*(1 - 0.01*strain[n - 1]);
        theory[k] = 1e-6*medium(1e3*mean[k], cell.coordination, cell.solid);
    }
    dem_world_destroy(world);
    if (study.failures) return study_end();
    study_figure path = {.title = "Oedometer: loading with small unloadings, and unloading", .x_label = "strain (%)", .y_label = "stress (kPa)"};
    study_figure stiff = {.title = "Stiffness in small unloadings", .x_label = "mean stress (kPa)", .y_label = "modulus of uniaxial strain (MPa)",
                          .log_x = 1, .log_y = 1, .x0 = 0.5, .x1 = 100, .y0 = 0.5, .y1 = 10};
    study_curve(&path, 0, STUDY_LINE, SAMPLES, strain, stress);
    study_curve(&stiff, "measured", STUDY_DOTS, LEVELS, mean, measured);
    study_curve(&stiff, "effective medium", STUDY_LINE, LEVELS, mean, theory);
    study_figure_write(&path, "path.svg");
    study_figure_write(&stiff, "stiffness.svg");
    study_result("load_error", 100*worst, "% at most, above 5 % of the largest load");
    study_result("strain_largest", strain[SAMPLES - 1 - PARTS], "%");
    study_result("strain_left", strain[SAMPLES - 1], "%");
    study_result("modulus", measured[LEVELS - 1], "MPa at the largest load");
    study_result("medium", theory[LEVELS - 1], "MPa, effective medium");
    study_result("exponent", log(measured[LEVELS - 1]/measured[3])/log(mean[LEVELS - 1]/mean[3]), "of modulus over mean stress, at lid stresses of 10 to 100 kPa");
    return study_end();
}
