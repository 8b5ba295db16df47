/* 05_moving_wall.c - a conveyor belt takes a resting ball along: moving walls, and what they measure.

   A plane that translates in itself is a belt of speed V. The ball on it slides at first and gains speed
   mu g t, and spin against the belt, until both surfaces move alike:
       v = 2/7 V,  R w = 5/7 V  at  t = 2 V/(7 mu g)
   The belt has then done the work 2/7 m V^2: half of it is in the ball, the other half became heat.

   Build:     cc -O2 05_moving_wall.c ../dem.c -lm; run with --replay: a film, 05_moving_wall.html
   Expected:  v, R w, the belt's work and the heat within 1 %; nothing missing from the ledger */
#include "../dem.h"
#include <math.h>
#include <string.h>

static int row(const char *name, double value, double expected) {   /* 1: off by more than 1 % */
    printf("%-22s %12.6g  %12.6g\n", name, value, expected);
    return !(fabs(value - expected) < 0.01*fabs(expected));
}

int main(int argc, char **argv) {
    const double belt_speed = 1, mu = 0.3, g = 9.81, radius = 0.01; /* m/s, -, m/s2, m */
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.gravity.z = -g;
    desc.ledger = 1;                                                /* account for energy */
    dem_world *world = dem_world_create(&desc);

    dem_material_desc rubber_desc = DEM_MATERIAL_DESC;
    rubber_desc.density = 1200;                                     /* kg/m3 */
    rubber_desc.young = 1e8;                                        /* Pa */
    rubber_desc.poisson = 0.45;
    rubber_desc.restitution = 0.3;
    rubber_desc.friction = mu;
    dem_material rubber = dem_material_add(world, &rubber_desc);

    dem_wall belt = dem_plane_add(world, rubber, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
    dem_motion motion = DEM_MOTION;
    motion.kind = DEM_MOTION_TRANSLATING;
    motion.velocity.x = belt_speed;
    dem_wall_motion(world, belt, &motion);
    dem_body ball = dem_sphere_add(world, rubber, radius, dem_vec3_make(0, 0, radius));

    dem_replay_desc film_desc = DEM_REPLAY_DESC;
    film_desc.interval = 0.002;                                 /* s */
    dem_replay *film = argc > 1 && !strcmp(argv[1], "--replay") ? dem_replay_open(world, "05_moving_wall.html", &film_desc) : 0;
    /* on the way: speed mu g t, up to 2/7 V */
    dem_body_state state;
    dem_check_print(world, stdout);
    printf("time [s]  speed [m/s]  expected\n");
    for (int i = 1; i <= 6; i++) {
        if (dem_world_run(world, 0.025, 0, 0) != DEM_OK) { puts(dem_world_error(world)); return 1; }
        dem_body_get(world, ball, &state);
        double t = dem_world_time(world), sliding = mu*g*t, rolling = 2*belt_speed/7;
        printf("%8.3f  %11.4f  %8.4f\n", t, state.velocity.x, sliding < rolling ? sliding : rolling);
    }

    dem_wall_loads loads;
    dem_wall_loads_get(world, belt, &loads);
    dem_ledger ledger = dem_ledger_get(world);
    double mv2 = state.mass*belt_speed*belt_speed;                  /* J */
    int wrong = 0;
    printf("%-22s %12s  %12s\n", "", "measured", "expected");
    wrong += row("speed [m/s]", state.velocity.x, 2*belt_speed/7);
    wrong += row("-R w [m/s]", -radius*state.spin.y, 5*belt_speed/7);
    wrong += row("work of the belt [J]", loads.work, 2*mv2/7);
    wrong += row("heat of sliding [J]", ledger.slide + ledger.tangent, mv2/7);
    printf("%-22s %12.6g\n", "unaccounted [J]", ledger.residual);
    wrong += !(fabs(ledger.residual) < 1e-3*ledger.throughput);
    dem_replay_close(film);                                         /* without --replay there is none */
    dem_world_destroy(world);
    return wrong > 0;
}
