/* accuracy.c - what a time step buys: the error of an elastic bounce, and of a heap of them, for every integrator.
   MIT licence.

   build/accuracy       seconds; results in build/out/accuracy, a table and two pictures among them

   The bounce: a bead of 1.5 mm meets a plane head on at 1 m/s, Hertz, restitution 1: it must leave as fast as it
   came. The error is |leaving energy/arriving energy - 1|, root mean square over 16 instants of first touch within
   a step. Through the public calls only.
   The price: time of a bead and step with each integrator on the bed of bench/scenes.h, in turns. Cost of a bounce
   is that times the steps it takes, in units of velocity Verlet's at 50 steps a contact, the library's own choice.
   The long run: 1000 such bounces between two planes, at 50 steps a contact: does energy drift? */
#define DEM_IMPLEMENTATION
#include "dem.h"
#include "examples/study.h"
#include "bench/measure.h"
#include "bench/scenes.h"

enum { SCHEMES = 5, STEPS = 6, PHASES = 16, TURNS = 5, BOUNCES = 1000 };
static const struct { dem_integrator which; const char *name; } schemes[SCHEMES] = {
    {DEM_VELOCITY_VERLET, "velocity_verlet"}, {DEM_LEAPFROG, "leapfrog"}, {DEM_POSITION_VERLET, "position_verlet"},
    {DEM_SYMPLECTIC_EULER, "symplectic_euler"}, {DEM_FORWARD_EULER, "forward_euler"}};
static const double steps_of_contact[STEPS] = {20, 30, 50, 100, 200, 400};
static FILE *page;

/* A bead between planes at z = 0 and, when gap > 0, z = 2 r + gap. */
static dem_world *bounce_world(dem_integrator which, double dt, double height, double gap,
                               double restitution) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc m = DEM_MATERIAL_DESC;
    dem_material glass;
    dem_body body;
    dem_body_state state;
    dem_world *world;
    int ok;
    desc.integrator = which;
    desc.dt = (dem_real)dt;
    desc.allow_large_dt = 1;     /* twenty steps may be just too few by rounding */
    desc.impact_speed = 1;
    desc.threads = 1;
    world = dem_world_create(&desc);
    if (!world) { study_fail("bounce: %s", dem_create_error(&desc)); return 0; }
    m.density = (dem_real)BENCH_DENSITY;
    m.young = (dem_real)BENCH_YOUNG;
    m.poisson = (dem_real)BENCH_POISSON;
    m.restitution = (dem_real)restitution;
    glass = dem_material_add(world, &m);
    body = dem_sphere_add(world, glass, (dem_real)BENCH_RADIUS, dem_vec3_make(0, 0, (dem_real)(BENCH_RADIUS + height)));
    ok = dem_body_get(world, body, &state) == DEM_OK;
    state.velocity.z = -1;
    ok = ok && dem_body_set(world, body, &state) == DEM_OK &&
         dem_plane_add(world, glass, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1)).id &&
         (gap <= 0 || dem_plane_add(world, glass, dem_vec3_make(0, 0, (dem_real)(2*BENCH_RADIUS + gap)),
                                    dem_vec3_make(0, 0, -1)).id);
    if (ok) return world;
    study_fail("bounce: %s", dem_world_error(world));
    dem_world_destroy(world);
    return 0;
}
static double contact_time(void) {
    dem_world *world = bounce_world(DEM_VELOCITY_VERLET, 0, 1e-4, 0, 1);
    dem_advice advice;
    double t = 0;
    if (world && dem_step_advice(world, &advice) == DEM_OK) t = (double)advice.contact_time;
    dem_world_destroy(world);
    return t;
}
static double kinetic(const dem_world *world) { return dem_totals_get(world).kinetic; }

/* Relative error of energy (restitution 1) or of restitution, root mean square over instants of first touch. */
static double bounce_error(dem_integrator which, double tc, double steps, double restitution) {
    const double dt = tc/steps;
    double sum = 0;
    int phase;
    for (phase = 0; phase < PHASES; phase++) {
        dem_world *world = bounce_world(which, dt, dt*(3 + (phase + 0.5)/PHASES), 0, restitution);
        double before, error;
        if (!world) return (double)NAN;
        before = kinetic(world);
        if (dem_world_step(world, (int)(1.5*steps) + 10) != DEM_OK) study_fail("%s", dem_world_error(world));
        error = kinetic(world)/before;
        error = restitution < 1 ? sqrt(error)/restitution - 1 : error - 1;
        sum += error*error;
        dem_world_destroy(world);
    }
    return sqrt(sum/PHASES);
}
/* Energy after BOUNCES of them over that before; free flight between takes a contact time. NAN: the run broke. */
static double long_run(dem_integrator which, double tc) {
    dem_world *world = bounce_world(which, tc/50, 0.37*tc, tc, 1);
    double before, most = 0;
    int k, broken = 0;
    if (!world) return (double)NAN;
    before = kinetic(world);
    for (k = 0; k < 20*BOUNCES && !broken; k++) { /* a bounce and a flight are 100 steps */
        broken = dem_world_step(world, 5) != DEM_OK;
        if (k >= 20*(BOUNCES - 1)) most = fmax(most, kinetic(world)); /* that of flight */
    }
    dem_world_destroy(world);
    return broken ? (double)NAN : most/before;
}

/* Time of a step on the bed with each integrator, over that of the first. */
static void prices(const char *folder, double ratio[SCHEMES]) {
    const bench_scene bed = bench_scene_read(folder, "bed");
    static double times[SCHEMES][BENCH_MOST_LOOPS];
    dem_world *worlds[SCHEMES];
    double ratios[BENCH_MOST_LOOPS];
    int k, turn, ok = 1;
    for (k = 0; k < SCHEMES; k++) {
        bench_choice choice = BENCH_CHOICE;
        choice.integrator = schemes[k].which;
        worlds[k] = bench_world(&bed, &choice);
        ok = ok && worlds[k] && dem_world_step(worlds[k], 50) == DEM_OK;
    }
    for (turn = 0; turn < TURNS && ok; turn++)
        for (k = 0; k < SCHEMES && ok; k++) {
            const double begun = study_clock();
            ok = dem_world_step(worlds[k], 60) == DEM_OK;
            times[k][turn] = study_clock() - begun;
        }
    for (k = 0; k < SCHEMES; k++) {
        for (turn = 0; turn < TURNS; turn++) ratios[turn] = times[k][turn]/times[0][turn];
        ratio[k] = ok ? bench_median(ratios, TURNS) : (double)NAN;
        dem_world_destroy(worlds[k]);
    }
    if (!ok) study_fail("the bed broke");
}

static void error_draw(const char *title, const char *label, const char *file, double cost[SCHEMES][STEPS],
                       double error[SCHEMES][STEPS]) {
    study_figure f;
    int k;
    memset(&f, 0, sizeof f);
    f.title = title;
    f.x_label = "cost of the bounce (velocity Verlet at 50 steps a contact = 1)";
    f.y_label = label;
    f.log_x = f.log_y = 1;
    f.x0 = -0.5; f.x1 = 1.1;
    for (k = 0; k < SCHEMES; k++)
        study_curve(&f, schemes[k].name, k == 1 || k == 2 ? STUDY_DASHED : STUDY_LINE, STEPS, cost[k], error[k]);
    study_figure_write(&f, file);
}
int main(int argc, char **argv) {
    static const char *folder = "bench/data", *out = "build/out/accuracy";
    static const study_option table[] = {
        {"data", STUDY_TEXT, &folder, 0, 0, "", "where the start states are"},
        {"out", STUDY_TEXT, &out, 0, 0, "", "folder of results"},
    };
    static double cost[SCHEMES][STEPS], error[2][SCHEMES][STEPS], energy[SCHEMES];
    const double load = bench_load();
    double ratio[SCHEMES], tc;
    char name[64];
    int i, k, n;
    study_options(argc, argv, "What a time step buys, for every integrator.", table, (int)(sizeof table/sizeof *table));
    study_begin(out);
    bench_machine();
    tc = contact_time();
    study_result("contact_time", tc, "s");
    prices(folder, ratio);
    page = bench_page_open();
    for (k = 0; k < SCHEMES; k++) {
        snprintf(study.prefix, sizeof study.prefix, "%s.", schemes[k].name);
        bench_result_short("price", ratio[k], "of velocity Verlet");
        for (n = 0; n < STEPS; n++) {
            cost[k][n] = ratio[k]*steps_of_contact[n]/50;
            for (i = 0; i < 2; i++) {
                error[i][k][n] = bounce_error(schemes[k].which, tc, steps_of_contact[n], i ? 0.66 : 1);
                snprintf(name, sizeof name, "steps%.0f.%s_error", steps_of_contact[n], i ? "restitution" : "energy");
                bench_result_short(name, error[i][k][n], "");
            }
        }
        energy[k] = long_run(schemes[k].which, tc);
        if (energy[k] == energy[k]) bench_result_short("energy_after_1000", energy[k], "of that at first");
        else study_result_text("energy_after_1000", "none", "(the run was stopped: it had become unstable)");
    }
    study.prefix[0] = 0;
    if (page) {
        bench_page_machine(page, load);
        for (i = 0; i < 2; i++) {
            fprintf(page, "%s\n\n| integrator | time of a step |", i ? "\nError of restitution, .66 asked:" : "Error of energy, restitution 1:");
            for (n = 0; n < STEPS; n++) fprintf(page, " t_c/%.0f |", steps_of_contact[n]);
            fprintf(page, " order |%s\n|---|---|---|---|---|---|---|---|---|%s\n", i ? "" : " energy after 1000 bounces |", i ? "" : "---|");
            for (k = 0; k < SCHEMES; k++) {
                fprintf(page, "| `%s` | %.2f |", schemes[k].name, ratio[k]);
                for (n = 0; n < STEPS; n++) fprintf(page, " %.1e |", error[i][k][n]);
                fprintf(page, " %.1f |", log(error[i][k][2]/error[i][k][STEPS - 1])/log(steps_of_contact[STEPS - 1]/steps_of_contact[2]));
                if (i) fprintf(page, "\n");
                else if (energy[k] == energy[k]) fprintf(page, " %.4f |\n", energy[k]);
                else fprintf(page, " run stopped |\n");
            }
        }
    }
    error_draw("An elastic bounce: error of energy against cost", "error of energy", "bounce_energy.svg", cost, error[0]);
    error_draw("A bounce at restitution .66: error against cost", "error of restitution", "bounce_restitution.svg", cost, error[1]);
    study_close(page, "page.md");
    return study_end();
}
