/* 11_advise.c - lesson 11: what accuracy costs in a scene of one's own: a drum that turns, tried on copies of it.

   Question:  the power that the drum takes shall be right within 10 %. How long may the time step be, and how soft the
              grains? And how much longer is a step when grains are 10 times softer: 10 times? Guess, then run.
   Theory:    a step has to resolve the duration of a collision, by Hertz's law 2.87 (m^2/(E^2 R v))^(1/5) of the
              reduced mass, modulus and radius: it goes with E^(-2/5), so that 10 times softer buys steps 2.5 times as
              long. The power is told by the torque's theorem too, w M g x of the centre of mass (lesson 8): a number to
              judge the runs by.
   dem_advise lets copies of a scene run on with other steps, other stiffnesses and other laws, each three times from
   places that hardly differ, so that a change is told from chance. The budget is wall time: on a busy machine trials
   simulate less.
   Build:     cc -O2 11_advise.c ../dem.c -lm
   Run:       11_advise, or 11_advise --replay for a film of the scene before it is tried, 11_advise.html
   Expected:  softer grains get steps 10^(2/5) = 2.51 times as long within 10 %; power = w M g x within 5 %; a scene as
              it was, to the last bit; and one sentence of advice
   Exercises: check with 11_advise --check N VALUE
   1  How much longer a step does a modulus lower by 100 buy: which factor?
   2  Glass beads of 3 mm diameter (2500 kg/m3, 70 GPa, Poisson .23) meet at 1 m/s. How long do they touch, in us?
      (Reduced: m/2, R/2, E/(2 (1 - nu^2)). dem_coefficients_get agrees, when impact_speed is 1.) */
#include "../dem.h"
#include "lesson.h"

static double answer(int exercise);

/* W, mean power since the loads were reset. Any function of the world will do; means are told from chance sooner than
   what is of one moment. */
static double power(const dem_world *world, void *drum) {
    dem_wall_loads loads;
    return dem_wall_loads_get(world, *(dem_wall *)drum, &loads) == DEM_OK ? loads.work/loads.time : 0;
}

int main(int argc, char **argv) {
    const int replay = lesson_begin(argc, argv, "11_advise", answer);
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

    dem_wall drum = dem_cylinder_add(world, glass, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1), 0.05, 1);
    dem_motion turning = DEM_MOTION;
    turning.kind = DEM_MOTION_ROTATING;
    turning.axis = dem_vec3_make(0, 0, 1);
    turning.speed = speed;
    dem_wall_motion(world, drum, &turning);
    dem_spheres_fill(world, glass, 2e-3, dem_box_make(-0.035, -0.035, 0, 0.035, 0.015, 0), 150, 1);
    dem_check_print(world, stdout);

    dem_replay_desc film_desc = DEM_REPLAY_DESC;
    film_desc.interval = 0.02;                                      /* s */
    dem_replay *film = replay ? dem_replay_open(world, "11_advise.html", &film_desc) : 0;
    double lever = 0;                                               /* m, of the weight about the axis: a mean */
    for (int i = 0; i < 50; i++) {
        if (i == 25) dem_wall_loads_reset(world, drum);
        if (dem_world_run(world, 0.02, 0, 0) != DEM_OK) { puts(dem_world_error(world)); return 1; }
        dem_replay_value(film, "w M g x (mW)", 1e3*speed*g*dem_totals_get(world).mass*dem_totals_get(world).centre[0]);
        if (i >= 25) lever += dem_totals_get(world).centre[0]/25;
    }
    dem_replay_close(film);
    const double direct = power(world, &drum), by_torque = speed*g*dem_totals_get(world).mass*lever;

    dem_wall_loads_reset(world, drum);
    dem_advise_desc how = DEM_ADVISE_DESC;
    how.duration = 1;                                               /* s of simulated time, each trial */
    how.budget = 10;                                                /* s of wall time, all of them */
    how.tolerance = 0.1;                                            /* share of the power by which it may be off */
    how.observable_count = 1;
    how.observables[0].name = "power";
    how.observables[0].unit = "W";
    how.observables[0].function = power;
    how.observables[0].user = &drum;
    how.progress = dem_progress_print;
    how.user = stderr;
    const uint64_t before = dem_world_hash(world);
    dem_trials trials;
    if (dem_advise(world, &how, &trials) != DEM_OK) { puts(dem_world_error(world)); return 1; }
    dem_trials_print(&trials, stdout);

    double as_it_is = 0, softer = 0;                                /* s, the steps of two trials */
    for (int k = 0; k < trials.count; k++) {
        const dem_trial *t = &trials.trial[k];
        if (t->step < 1.01 && t->step > 0.99 && t->stiffness < 0.11) softer = t->dt;
        if (k == 0) as_it_is = t->dt;
    }
    lesson_row("10 times softer: steps longer by", softer/as_it_is, 0, pow(10, 0.4), 10);
    lesson_row("power [mW] beside w M g x", 1e3*direct, 0, 1e3*by_torque, 5);
    lesson_range("bits of the scene that the trials changed", dem_world_hash(world) != before, 0, 0, 0);
    lesson_range("letters of advice", (double)strlen(trials.advice), 0, 20, 400);
    dem_world_destroy(world);
    return lesson_end();
}

/* The marking. Stop here if you want to find the answers by yourself. */
static double answer(int exercise) {
    const double R = 1.5e-3, m = 4*3.14159265/3*R*R*R*2500, E = 70e9/(2*(1 - 0.23*0.23));
    return exercise == 1 ? pow(100, 0.4) : 1e6*2.87*pow(m*m/4/(E*E*R/2*1), 0.2);
}
