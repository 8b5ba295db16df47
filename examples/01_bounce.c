/* 01_bounce.c - lesson 1: a bouncing ball. You learn: world, material, wall, grain, time step, restitution.

   Build:     cc -O2 -o 01_bounce 01_bounce.c ../dem.c -lm      (in the folder examples)
   Run:       ./01_bounce or, with a replay of the falling arches, ./01_bounce --replay
   Question:  A glass ball falls 0.5 m onto a floor. After each impact it has 80 % of the speed that it had before it
              (coefficient of restitution e = 0.8). What fraction of its height does it reach again? Does it bounce
              for ever? Write down both answers, then run. */
#include "../dem.h"
#include "lesson.h"

int main(int argc, char **argv) {
    const int record = lesson_begin(argc, argv, "01_bounce");
    const double restitution = 0.8, height = 0.5, radius = 0.01, g = 9.81;  /* -, m, m, m/s2: change them here */
    const double rest = sqrt(2*height/g)*(1 + restitution)/(1 - restitution);   /* s, expected end of the impacts */

    /* the world: where a field stays 0, dem.h chooses its value, or its effect is off */
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.gravity.z = -g;                                            /* m/s2 */
    desc.dt = 2e-6;                 /* s, time step: a contact lasts 150 steps. With 0 dem.h chooses 6e-6 s, which is
                                       enough for heaps; here rebounds would be off by up to 1.5 % */
    dem_world *world = dem_world_create(&desc);

    /* the material of ball and floor. Young's modulus of glass is 7e10 Pa; here it is 1e9 Pa. A contact of a softer
       ball lasts longer, so a longer step is enough */
    dem_material_desc glass_desc = DEM_MATERIAL_DESC;
    glass_desc.density = 2500;                                      /* kg/m3 */
    glass_desc.young = 1e9;                                         /* Pa */
    glass_desc.poisson = 0.23;                                      /* -, Poisson's ratio */
    glass_desc.restitution = restitution;
    dem_material glass = dem_material_add(world, &glass_desc);
    dem_vec3 point = dem_vec3_make(0, 0, 0), normal = dem_vec3_make(0, 0, 1);   /* normal: from floor to ball */
    dem_wall_plane_add(world, glass, point, normal);
    dem_body ball = dem_sphere_add(world, glass, radius, dem_vec3_make(0, 0, radius + height));
    dem_world_check_print(world, stdout);                           /* prints likely mistakes: here none */

    dem_replay_desc replay_desc = DEM_REPLAY_DESC;
    replay_desc.interval = 0.01;                                    /* s, from frame to frame */
    dem_replay *replay = record ? dem_replay_open(world, "01_bounce.html", &replay_desc) : 0;

    /* the run: one step at a time, to find the steps at which the ball begins to fall */
    double expected = height, last_speed = 0, last_rise = 0;        /* m, m/s, s */
    int bounces = 0;
    while (dem_world_time_get(world) < 1.2*rest) {
        if (dem_world_step(world, 1) != DEM_OK) { puts(dem_world_error_get(world)); return 1; }
        dem_body_state state;
        dem_body_get(world, ball, &state);
        double bottom = state.position.z - radius;                  /* m above the floor */
        dem_replay_value_set(replay, "height (m)", bottom);         /* does nothing without a replay */
        if (last_speed > 0 && state.velocity.z <= 0 && bounces < 5) {
            char name[48];
            expected *= restitution*restitution;
            bounces++;
            snprintf(name, sizeof name, "height of rebound %d [m]", bounces);
            lesson_row(name, bottom, 0, expected, 1);
        }
        if (state.velocity.z > 0.02) last_rise = dem_world_time_get(world);     /* m/s; a slower ball is at rest */
        last_speed = state.velocity.z;
    }
    lesson_row("time until the ball lies still [s]", last_rise, 0, rest, 2);
    lesson_claim("the ball rebounds five times", bounces == 5);
    dem_replay_close(replay);
    dem_world_destroy(world);
    return lesson_end();
}

/* STOP: answer the question before you read on.
   Theory:    A fall from height h ends with speed v = sqrt(2 g h). After n impacts the speed is v e^n, so rebound n
              reaches h e^(2n). Each flight lasts e times as long as the flight before. The flight times form a
              geometric series with a finite sum, so infinitely many impacts end at the time
                  t = sqrt(2 h/g) (1 + e)/(1 - e)
   Output:    the heights of five rebounds (within 1 %) and the time at which the ball lies still (within 2 %). Impacts
              do not begin exactly at a step, hence small errors of either sign. The ball counts as still when it rises
              more slowly than 0.02 m/s, so the measured time is a little short. With e below 0.6 the late impacts are
              so slow that gravity during the contact matters: rebounds 2 to 5 may then leave their limits. */
/* Exercises for ./01_bounce --check N VALUE. {2: 1 to 3 by 0.1} is 2 or, for --seed NAME, in that range. */
const char *const exercises[2] = {
    "A ball with e = {0.7: 0.6 to 0.9 by 0.01} falls from {2: 1 to 3 by 0.1} m. How high is its fifth rebound, in m?",
    "A ball falls from {1: 0.5 to 2 by 0.1} m and lies still after {3: 1 to 4 by 0.1} s. What is its restitution?"
    " To confirm it, set `restitution` and `height` at the top of main, build and run: the last row keeps its limits."};
/* Marking. Stop here if you want to find the answers yourself. */
double answer(int exercise, const double *x) {
    if (exercise == 1) return x[1]*pow(x[0], 10);
    const double t = x[1]/sqrt(2*x[0]/9.81);                        /* in units of the time of fall: (1 + e)/(1 - e) */
    return (t - 1)/(t + 1);
}
