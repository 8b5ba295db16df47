/* 01_bounce.c - lesson 1: a glass ball falls half a metre and bounces.

   Question:  it keeps 80 % of its speed in every impact (restitution e = .8). Which share of its height does it keep?
              And does it bounce for ever? Write down both answers, then run.
   Theory:    speed v falls from height v^2/(2 g): rebound n reaches h e^(2n). Each flight lasts e times as long as the
              one before; the sum of them all is finite: the ball lies still at sqrt(2 h/g) (1 + e)/(1 - e).
   Build:     cc -O2 01_bounce.c ../dem.c -lm
   Run:       01_bounce, or 01_bounce --replay for a film, 01_bounce.html: arches, each lower and shorter than the one
              before
   Expected:  five heights within 1 %, the time at which it lies still within 2 %
   Exercises: check with 01_bounce --check N VALUE
   1  A ball with e = .7 is dropped from 2 m. How high is its fifth rebound, in m?
   2  Which restitution lets a ball dropped from 1 m lie still after 3 s? (Make the program confirm it.) */
#include "../dem.h"
#include "lesson.h"

static double answer(int exercise);

int main(int argc, char **argv) {
    const int replay = lesson_begin(argc, argv, "01_bounce", answer);
    const double restitution = 0.8, height = 0.5, radius = 0.01, g = 9.81;  /* -, m, m, m/s2 */

    /* the world: what is left at zero is absent, or chosen for you */
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.gravity.z = -g;
    dem_world *world = dem_world_create(&desc);

    /* what ball and floor are made of; the true modulus of glass is 7e10 Pa, a softer one allows longer steps */
    dem_material_desc glass_desc = DEM_MATERIAL_DESC;
    glass_desc.density = 2500;                                      /* kg/m3 */
    glass_desc.young = 1e9;                                         /* Pa */
    glass_desc.poisson = 0.23;
    glass_desc.restitution = restitution;
    dem_material glass = dem_material_add(world, &glass_desc);
    dem_wall_plane_add(world, glass, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
    dem_body ball = dem_sphere_add(world, glass, radius, dem_vec3_make(0, 0, radius + height));
    dem_world_check_print(world, stdout);                                 /* says what looks wrong: here, nothing */

    dem_replay_desc film_desc = DEM_REPLAY_DESC;
    film_desc.interval = 0.01;                                      /* s, from frame to frame */
    dem_replay *film = replay ? dem_replay_open(world, "01_bounce.html", &film_desc) : 0;

    /* the run: one step at a time, for we want the moment at which the ball turns round */
    double expected = height, last_speed = 0, last_impact = 0;
    int bounces = 0;
    while (dem_world_time_get(world) < 3.2) {
        if (dem_world_step(world, 1) != DEM_OK) { puts(dem_world_error_get(world)); return 1; }
        dem_body_state state;
        dem_body_get(world, ball, &state);
        double bottom = state.position.z - radius;                  /* m, of the ball above the floor */
        dem_replay_value_set(film, "height (m)", bottom);               /* without a film nothing happens */
        if (last_speed > 0 && state.velocity.z <= 0 && bounces < 5) {
            char name[32];
            expected *= restitution*restitution;
            snprintf(name, sizeof name, "height of rebound %d [m]", ++bounces);
            lesson_row(name, bottom, 0, expected, 1);
        }
        if (state.velocity.z > 0.02) last_impact = dem_world_time_get(world);   /* m/s: it still leaves the floor */
        last_speed = state.velocity.z;
    }
    lesson_row("lies still at [s]", last_impact, 0, sqrt(2*height/g)*(1 + restitution)/(1 - restitution), 2);
    lesson_range("rebounds counted (five are looked for)", bounces, 0, 5, 5);
    dem_replay_close(film);
    dem_world_destroy(world);
    return lesson_end();
}

/* The marking. Stop here if you want to find the answers by yourself. */
static double answer(int exercise) {
    const double t = 3/sqrt(2*1/9.81);                              /* in times of the fall: (1 + e)/(1 - e) */
    return exercise == 1 ? 2*pow(0.7, 10) : (t - 1)/(t + 1);
}
