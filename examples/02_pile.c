/* 02_pile.c - lesson 2: heaps, and what they stand on.

   Question:  discs (logs, seen from their ends) slump from a column. Does friction alone make a heap? What does
              resistance to rolling do? And which friction holds the smallest heap there is, one log on two? Write it
              down, then run.
   Theory:    of a wedge of height H and half width L, the mean height is H/3 and the mean distance from the middle L/3,
              so that tan(slope) is their ratio. Three logs: floor and upper log rub a lower one
              alike, or it would turn. So the force between two logs halves the angle, 30 degrees, between their normal
              and the vertical: mu >= tan(15 degrees) = .268 between logs, and a third of that on the floor.
   Build:     cc -O2 02_pile.c ../dem.c -lm
   Run:       02_pile, or 02_pile --replay for a film of the steepest heap, 02_pile.html
   Expected:  the slope grows with rolling friction; three logs stand from mu = .268 on, within 3 %
   Exercises: check with 02_pile --check N VALUE
   1  The logs are rough. Which friction must the floor have at least, for three logs to stand on it?
   2  The lower logs lie apart by a gap of one radius. Which friction between logs holds the upper one now? */
#include "../dem.h"
#include "lesson.h"

static double answer(int exercise);

/* A world of discs in the x-y plane, with a floor: y = 0. */
static dem_world *yard(double friction, double rolling, dem_material *wood) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.planar = 1;
    desc.thickness = 0.01;                                          /* m, length of the logs */
    desc.gravity.y = -9.81;                                         /* m/s2 */
    dem_world *world = dem_world_create(&desc);
    dem_material_desc wood_desc = DEM_MATERIAL_DESC;
    wood_desc.density = 700;                                        /* kg/m3 */
    wood_desc.young = 1.5e7;                                          /* Pa, softened */
    wood_desc.poisson = 0.3;
    wood_desc.restitution = 0.3;
    wood_desc.friction = friction;
    wood_desc.rolling_friction = rolling;                           /* of the radius */
    *wood = dem_material_add(world, &wood_desc);
    dem_wall_plane_add(world, *wood, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 1, 0));
    return world;
}
/* Degrees: the slope of what becomes of a column when the walls beside it are drawn up; < 0: the run broke. */
static double slope(double rolling, int seed, int replay, double *overlap) {
    const double R = 0.005, half = 0.03;                            /* m, of a disc; half the width of the column */
    dem_material wood;
    dem_world *world = yard(0.5, rolling, &wood);
    dem_real corners[8] = {-half, 0, -half, 0.23, half, 0, half, 0.23};
    int32_t sides[4] = {0, 1, 2, 3};
    dem_profile walls = {4, 2, corners, sides};
    dem_wall column = dem_wall_profile_add(world, wood, &walls, DEM_EDGE_RESOLVED);
    for (int i = 0; i < 2; i++)                                     /* two sizes, lest they lie like bricks */
        dem_spheres_fill(world, wood, i ? 0.8*R : R,
                         dem_region_make(dem_box_make(-half, 0, 0, half, 0.22, 0)), 55,
                         (uint64_t)(2*seed + i));
    dem_motion up = DEM_MOTION;
    up.kind = DEM_MOTION_TRANSLATING;
    up.velocity.y = 0.4;                                            /* m/s */
    up.start = 0.25;                                                /* s: when all have fallen */
    dem_wall_motion_set(world, column, &up);

    dem_replay_desc film_desc = DEM_REPLAY_DESC;
    film_desc.interval = 0.02;                                      /* s */
    dem_replay *film = replay ? dem_replay_open(world, "02_pile.html", &film_desc) : 0;
    double degrees = 0;
    for (int i = 0; i < 60; i++) {
        if (dem_world_run(world, 0.02, 0, 0) != DEM_OK) { puts(dem_world_error_get(world)); return -1; }
        dem_bodies discs = dem_bodies_get(world);
        double height = 0, distance = 0;
        for (int k = 0; k < discs.count; k++) {
            height += discs.positions[4*k + 1] - R;
            distance += fabs(discs.positions[4*k]);
        }
        degrees = atan(height/distance)*180/3.14159265;
        dem_replay_value_set(film, "slope (degrees)", degrees);
    }
    if (dem_counters_get(world).overlap_max > *overlap) *overlap = dem_counters_get(world).overlap_max;
    dem_replay_close(film);
    dem_world_destroy(world);
    return degrees;
}
/* Do three logs stand, the lower ones touching each other? 1: yes. */
static int stands(double friction) {
    const double R = 0.05;                                          /* m */
    dem_material wood;
    dem_world *world = yard(friction, 0, &wood);
    dem_body_state top;
    dem_sphere_add(world, wood, R, dem_vec3_make(-R, R, 0));
    dem_sphere_add(world, wood, R, dem_vec3_make(R, R, 0));
    dem_body upper = dem_sphere_add(world, wood, R, dem_vec3_make(0, R + sqrt(3.0)*R, 0));
    if (dem_world_run(world, 1, 0, 0) != DEM_OK) puts(dem_world_error_get(world));
    dem_body_get(world, upper, &top);
    dem_world_destroy(world);
    return top.position.y > 2.5*R;
}

int main(int argc, char **argv) {
    const int replay = lesson_begin(argc, argv, "02_pile", answer);
    const double rolling[3] = {0, 0.1, 0.5};
    double mean[3], error[3], low = 0.1, high = 0.5, overlap = 0;
    for (int row = 0; row < 3; row++) {
        double degrees[3];                                          /* three seeds: one heap says little */
        for (int seed = 0; seed < 3; seed++)
            degrees[seed] = slope(rolling[row], seed + 1, replay && row == 2 && !seed, &overlap);
        mean[row] = lesson_mean(degrees, 3, &error[row]);
        printf("rolling friction %.1f: slope %4.1f +- %.1f degrees\n", rolling[row], mean[row], error[row]);
    }
    while (high - low > 0.002) *(stands((low + high)/2) ? &high : &low) = (low + high)/2;

    lesson_range("slope without rolling friction [degrees]", mean[0], error[0], 0, 12);
    lesson_range("it grows with rolling friction .1 by", mean[1] - mean[0], hypot(error[0], error[1]), 2, 20);
    lesson_range("and on to .5 by", mean[2] - mean[1], hypot(error[1], error[2]), 1, 20);
    lesson_row("three logs stand from friction", (low + high)/2, (high - low)/2, tan(15*3.14159265/180), 3);
    lesson_range("largest overlap [of the radius]", overlap, 0, 0, 0.05);
    return lesson_end();
}

/* The marking. Stop here if you want to find the answers by yourself. */
static double answer(int exercise) {
    return exercise == 1 ? tan(3.14159265/12)/3 : tan(asin(3.0/4)/2);
}
