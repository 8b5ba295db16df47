/* 11_advise.c - lesson 11: what accuracy costs. You learn: time step, stiffness and chance in your own scene.

   Build:     cc -O2 -o 11_advise 11_advise.c ../dem.c -lm      (in the folder examples)
   Run:       ./11_advise or, with a replay of the scene before the trials, ./11_advise --replay
   Question:  The power of a drum must be right within 10 %. How long may the time step be, and how soft the grains?
              Does a step become 10 times as long if grains are 10 times softer? Guess, then run.
   Method:    dem_trials_run continues copies of the scene with other steps, stiffnesses and laws. Each trial runs three
              times from positions that hardly differ, which shows whether a change is statistically significant. The
              budget is in seconds of wall time: on a busy machine the trials simulate less. */
#include "../dem.h"
#include "lesson.h"

/* Returns the mean power since the loads were reset, W: an observable. Any function of the world may be one; means have
   smaller statistical errors than values of one moment. */
static double power(const dem_world *world, void *drum) {
    dem_wall_loads loads;
    return dem_wall_loads_get(world, *(dem_wall *)drum, &loads) == DEM_OK ? loads.work/loads.time : 0;
}

int main(int argc, char **argv) {
    const int record = lesson_begin(argc, argv, "11_advise");
    const double speed = 5, g = 9.81;                               /* rad/s, m/s2 */
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.planar = 1;
    desc.thickness = 4e-3;                                          /* m, of the discs */
    desc.gravity.y = -g;
    desc.threads = 1;
    dem_world *world = dem_world_create(&desc);
    dem_material_desc glass_desc = DEM_MATERIAL_DESC;
    glass_desc.density = 2500;                                      /* kg/m3 */
    glass_desc.young = 2e7;                                         /* Pa */
    glass_desc.poisson = 0.25;
    glass_desc.restitution = 0.6;
    glass_desc.friction = 0.4;
    dem_material glass = dem_material_add(world, &glass_desc);

    dem_wall drum = dem_wall_cylinder_add(world, glass, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1), 0.05, 1);
    dem_motion turning = DEM_MOTION;
    turning.kind = DEM_MOTION_ROTATING;
    turning.axis = dem_vec3_make(0, 0, 1);
    turning.speed = speed;
    dem_wall_motion_set(world, drum, &turning);
    dem_spheres_fill(world, glass, 2e-3,
                     dem_region_make(dem_box_make(-0.035, -0.035, 0, 0.035, 0.015, 0)), 150, 1);
    dem_world_check_print(world, stdout);

    dem_replay_desc replay_desc = DEM_REPLAY_DESC;
    replay_desc.interval = 0.02;                                    /* s */
    dem_replay *replay = record ? dem_replay_open(world, "11_advise.html", &replay_desc) : 0;
    double lever = 0;                                               /* m, mean lever arm of the weight */
    for (int i = 0; i < 50; i++) {
        if (i == 25) dem_wall_loads_reset(world, drum);
        if (dem_world_run(world, 0.02, 0, 0) != DEM_OK) { puts(dem_world_error_get(world)); return 1; }
        const dem_totals t = dem_totals_get(world);
        dem_replay_value_set(replay, "w M g x (mW)", 1e3*speed*g*t.mass*t.centre[0]);
        if (i >= 25) lever += t.centre[0]/25;
    }
    dem_replay_close(replay);
    const double direct = power(world, &drum), by_torque = speed*g*dem_totals_get(world).mass*lever;

    dem_wall_loads_reset(world, drum);
    dem_trials_desc how = DEM_TRIALS_DESC;
    how.duration = 1;                                               /* s of simulated time per trial */
    how.budget = 10;                                                /* s of wall time for all trials */
    how.tolerance = 0.1;                                            /* allowed relative deviation of the power */
    how.observable_count = 1;
    how.observables[0].name = "power";
    how.observables[0].unit = "W";
    how.observables[0].function = power;
    how.observables[0].user = &drum;
    how.progress = dem_progress_print;
    how.user = stderr;
    const uint64_t before = dem_world_hash_get(world);
    dem_trials trials;
    if (dem_trials_run(world, &how, &trials) != DEM_OK) { puts(dem_world_error_get(world)); return 1; }
    dem_trials_print(&trials, stdout);

    double as_it_is = 0, softer = 0;                                /* s, the steps of two trials */
    for (int k = 0; k < trials.count; k++) {
        const dem_trial *t = &trials.trial[k];
        if (t->step < 1.01 && t->step > 0.99 && t->stiffness < 0.11) softer = t->dt;
        if (k == 0) as_it_is = t->dt;
    }
    lesson_row("factor on the step if 10 times softer", softer/as_it_is, 0, pow(10, 0.4), 10);
    lesson_row("power, and w M g x [mW]", 1e3*direct, 0, 1e3*by_torque, 5);
    lesson_claim("the trials leave the scene as it was, bit for bit", dem_world_hash_get(world) == before);
    lesson_claim("the trials give advice", strlen(trials.advice) > 20);
    dem_world_destroy(world);
    return lesson_end();
}

/* STOP: answer the question before you read on.
   Theory:    A step must resolve a collision, which by Hertz's law lasts 2.87 (m^2/(E^2 R v))^(1/5), with the reduced
              mass m, modulus E, radius R and the speed v. This is proportional to E^(-2/5): grains that are 10 times
              softer allow steps 2.5 times as long. The theorem of lesson 8 gives the power, too: w M g x.
   Output:    the table of trials with advice; steps longer by 10^(2/5) = 2.51 (within 10 %); power = w M g x (5 %) */
/* Exercises for ./11_advise --check N VALUE. {2: 1 to 3 by 0.1} is 2 or, for --seed NAME, in that range. */
const char *const exercises[2] = {
    "By which factor does the step grow if the modulus is {100: 5 to 500 by 5} times smaller?",
    "Glass beads of {3: 1 to 6 by 0.1} mm diameter (2500 kg/m3, 70 GPa, Poisson's ratio 0.23) collide at "
    "{1: 0.2 to 3 by 0.1} m/s. How long do they touch, in us? (Reduced: m/2, R/2, E/(2 (1 - nu^2)). "
    "dem_coefficients_get confirms it if impact_speed is that speed.)"};
/* Marking. Stop here if you want to find the answers yourself. */
double answer(int exercise, const double *x) {
    if (exercise == 1) return pow(x[0], 0.4);
    const double R = x[0]/2000, m = 4*3.14159265/3*R*R*R*2500, E = 70e9/(2*(1 - 0.23*0.23));
    return 1e6*2.87*pow(m*m/4/(E*E*R/2*x[1]), 0.2);
}
