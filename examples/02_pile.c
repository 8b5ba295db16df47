/* 02_pile.c - lesson 2: heaps. You learn: sliding friction, rolling resistance, error bars from several runs.

   Build:     cc -O2 -o 02_pile 02_pile.c ../dem.c -lm      (in the folder examples)
   Run:       ./02_pile or, with a replay of the steepest heap, ./02_pile --replay
   Question:  A column of logs (discs, seen from the end) collapses. Is friction enough to make a heap? What does
              rolling resistance change? How much friction does the smallest heap need, one log on two? Write down
              three answers, then run. */
#include "../dem.h"
#include "lesson.h"

/* A world of discs in the x-y plane, with a floor: y = 0. */
static dem_world *yard(double friction, double rolling, dem_material *wood) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.planar = 1;
    desc.thickness = 0.01;                                          /* m, length of the logs */
    desc.gravity.y = -9.81;                                         /* m/s2 */
    dem_world *world = dem_world_create(&desc);
    dem_material_desc wood_desc = DEM_MATERIAL_DESC;
    wood_desc.density = 700;                                        /* kg/m3 */
    wood_desc.young = 1.5e7;                                        /* Pa, softened */
    wood_desc.poisson = 0.3;
    wood_desc.restitution = 0.3;
    wood_desc.friction = friction;
    wood_desc.rolling_friction = rolling;                           /* moment <= this x force x R*, R/2 between logs */
    *wood = dem_material_add(world, &wood_desc);                    /* 1/R* = 1/R1 + 1/R2; 1/R = 0 for a floor */
    dem_wall_plane_add(world, *wood, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 1, 0));
    return world;
}
/* Returns the slope (degrees) of the heap that remains of a column when its side walls move up; -1: the run failed. */
static double slope(double rolling, int seed, int record, double *overlap) {
    const double R = 0.005, half = 0.03; int placed = 0;            /* m, of a disc; half the width of the column */
    dem_material wood; dem_world *world = yard(0.5, rolling, &wood);
    dem_real corners[8] = {-half, 0, -half, 0.23, half, 0, half, 0.23}; /* x, y of four corners, m */
    int32_t sides[4] = {0, 1, 2, 3};                                /* two sides, from corner 0 to 1 and from 2 to 3 */
    dem_profile walls = {4, 2, corners, sides};                     /* 4 corners, 2 sides */
    dem_wall column = dem_wall_profile_add(world, wood, &walls, DEM_EDGE_RESOLVED);     /* one surface */
    for (int i = 0; i < 2; i++)                                     /* two sizes, 100 to 109 discs: no regular order */
        placed += dem_spheres_fill(world, wood, i ? 0.8*R : R,
                         dem_region_make(dem_box_make(-half, 0, 0, half, 0.22, 0)), 55, (uint64_t)(2*seed + i));
    if (placed < 95) { printf("only %d of 110 logs found room; raise the column\n", placed); return -1; }
    dem_motion up = DEM_MOTION;
    up.kind = DEM_MOTION_TRANSLATING; up.velocity.y = 0.4;          /* m/s */
    up.start = 0.25;                                                /* s: when all have fallen */
    dem_wall_motion_set(world, column, &up);
    dem_replay_desc replay_desc = DEM_REPLAY_DESC;
    replay_desc.interval = 0.02;                                    /* s */
    dem_replay *replay = record ? dem_replay_open(world, "02_pile.html", &replay_desc) : 0;
    double degrees = 0;
    for (int i = 0; i < 60; i++) {
        if (dem_world_run(world, 0.02, 0, 0) != DEM_OK) { puts(dem_world_error_get(world)); return -1; }
        dem_bodies discs = dem_bodies_get(world);
        double height = 0, distance = 0;
        for (int k = 0; k < discs.count; k++) {
            height += discs.positions[4*k + 1] - R;                 /* y, above a large disc on the floor */
            distance += fabs(discs.positions[4*k]);                 /* x; four numbers: x, y, z, radius */
        }
        degrees = atan(height/distance)*180/3.14159265;
        dem_replay_value_set(replay, "slope (degrees)", degrees);
    }
    *overlap = fmax(*overlap, dem_counters_get(world).overlap_max);
    dem_replay_close(replay);
    dem_world_destroy(world);
    return degrees;
}
/* Returns 1 if three logs, the lower ones touching each other, stay stacked. */
static int stands(double friction) {
    const double R = 0.05;                                          /* m */
    dem_material wood;
    dem_world *world = yard(friction, 0, &wood);
    dem_sphere_add(world, wood, R, dem_vec3_make(-R, R, 0));
    dem_sphere_add(world, wood, R, dem_vec3_make(R, R, 0));
    dem_body upper = dem_sphere_add(world, wood, R, dem_vec3_make(0, R + sqrt(3.0)*R, 0));
    if (dem_world_run(world, 1, 0, 0) != DEM_OK) puts(dem_world_error_get(world));
    dem_body_state top;
    dem_body_get(world, upper, &top);
    dem_world_destroy(world);
    return top.position.y > 2.5*R;
}

int main(int argc, char **argv) {
    const int record = lesson_begin(argc, argv, "02_pile");
    const double rolling[3] = {0, 0.1, 0.5};
    double mean[3], error[3], low = 0.1, high = 0.5, overlap = 0;
    for (int row = 0; row < 3; row++) {
        double degrees[3];                                          /* three seeds, for an error bar */
        for (int seed = 0; seed < 3; seed++)
            degrees[seed] = slope(rolling[row], seed + 1, record && row == 2 && !seed, &overlap);
        mean[row] = lesson_mean(degrees, 3, &error[row]);
    }
    while (high - low > 0.002)                                      /* bisection: halve the interval */
        if (stands((low + high)/2)) high = (low + high)/2; else low = (low + high)/2;
    lesson_range("slope, rolling friction 0 [degrees]", mean[0], error[0], 0, 12);
    lesson_range("slope, rolling friction 0.1 [degrees]", mean[1], error[1], 3, 20);
    lesson_range("slope, rolling friction 0.5 [degrees]", mean[2], error[2], 8, 30);
    lesson_claim("rolling friction makes heaps steeper", mean[1] > mean[0] + 2 && mean[2] > mean[1] + 1);
    lesson_row("smallest mu that holds three logs", (low + high)/2, (high - low)/2, tan(15*3.14159265/180), 3);
    lesson_range("largest overlap [radii]", overlap, 0, 0, 0.05);
    return lesson_end();
}

/* STOP: answer the question before you read on.
   Theory:    A wedge of height H and half width L has the mean height H/3 and the mean distance L/3 from its middle
              (the centroid of a triangle), so tan(slope) is the ratio of the two means.
              Three logs of weight W: the torques of floor and upper log on a lower log balance, so both friction
              forces have the same size T. Let N be the normal force of the upper log, 30 degrees from the vertical.
              The lower logs touch but are about to part, so they exert no force on each other. Then
                  horizontally, lower log: T + T cos 30 = N sin 30, so T/N = tan 15 degrees = 0.268 <= mu
                  vertically: N = W/2 between two logs, and 3/2 W on the floor below each lower log
   Output:    slopes (mean and standard error of three runs): the second at least 2 degrees above the first, the third
              at least 1 above the second; the smallest mu (within 3 %), by bisection: +- half of the last width */
/* Exercises for ./02_pile --check N VALUE. {2: 1 to 3 by 0.1} is 2 or, for --seed NAME, in that range. */
const char *const exercises[2] = {
    "The logs do not slide on each other. All have the same size, but the upper one weighs {1: 0.4 to 4 by 0.1} times "
    "as much as each lower one. How much friction must the floor have for three logs to stay?",
    "Now the lower logs leave a gap of {1: 0.2 to 1.8 by 0.1} radii. What friction between logs holds the upper one?"};
/* Marking. Stop here if you want to find the answers yourself. */
double answer(int exercise, const double *x) {
    return exercise == 1 ? x[0]/(2 + x[0])*tan(3.14159265/12) : tan(asin((2 + x[0])/4)/2);
}
