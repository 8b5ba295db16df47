/* 01_bounce.c - a glass ball falls half a metre and bounces; every rebound reaches e^2 of the last height.

   Build:     cc -O2 01_bounce.c ../dem.c -lm; run with --replay: a film, 01_bounce.html
   Expected:  heights .32 .2048 .1311 .0839 .0537 m for e = .8, each within 2 % */
#include "../dem.h"
#include <string.h>

int main(int argc, char **argv) {
    const double restitution = 0.8, height = 0.5, radius = 0.01;    /* -, m, m */
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.gravity.z = -9.81;                                         /* m/s2 */
    dem_world *world = dem_world_create(&desc);
    dem_material_desc glass_desc = DEM_MATERIAL_DESC;
    glass_desc.density = 2500;                                      /* kg/m3 */
    glass_desc.young = 1e10;                                        /* Pa */
    glass_desc.poisson = 0.23;
    glass_desc.restitution = restitution;
    dem_material glass = dem_material_add(world, &glass_desc);
    dem_plane_add(world, glass, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
    dem_body ball = dem_sphere_add(world, glass, radius, dem_vec3_make(0, 0, radius + height));

    dem_replay_desc film_desc = DEM_REPLAY_DESC;
    film_desc.interval = 0.01;                                  /* s */
    dem_replay *film = argc > 1 && !strcmp(argv[1], "--replay") ? dem_replay_open(world, "01_bounce.html", &film_desc) : 0;
    dem_body_state state;
    double expected = height, last_speed = 0;
    int bounces = 0, wrong = 0;
    dem_check_print(world, stdout);                                 /* says what looks wrong: here, nothing */
    printf("bounce  time [s]  height [m]  expected\n");
    while (bounces < 5 && dem_world_time(world) < 5) {
        if (dem_world_step(world, 1) != DEM_OK) { puts(dem_world_error(world)); return 1; }
        dem_body_get(world, ball, &state);
        if (last_speed > 0 && state.velocity.z <= 0) {              /* the top of its flight */
            double reached = state.position.z - radius;
            expected *= restitution*restitution;
            printf("%6d  %8.4f  %10.4f  %8.4f\n", ++bounces, dem_world_time(world), reached, expected);
            wrong += !(reached > 0.98*expected && reached < 1.02*expected);
        }
        last_speed = state.velocity.z;
    }
    dem_replay_close(film);                                         /* without --replay there is none */
    dem_world_destroy(world);
    return wrong > 0 || bounces < 5;
}
