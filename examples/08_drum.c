/* 08_drum.c - lesson 8: a rotating drum. You learn: torque and power; how to test a simulation by a theorem.

   Build:     cc -O2 -o 08_drum 08_drum.c ../dem.c -lm      (in the folder examples)
   Run:       ./08_drum or, with a replay at the Froude number Fr = w^2 R/g = 0.05, ./08_drum --replay
   Question:  Does friction determine the torque of a drum? Does a steeper charge need more torque? Above which speed
              do grains stay on the shell and never fall? Write down three answers, then run. */
#include "../dem.h"
#include "lesson.h"

enum { SIDES = 24, FRAMES = 80, LATE = 30 };    /* of the shell; of 0.02 s; first frame of the means */
static const double R = 0.04, r = 1.5e-3, g = 9.81, pi = 3.14159265;    /* m, drum; m, grains; m/s2 */

typedef struct turned { double torque, lever, angle, above, overlap; } turned;  /* N m, N m, degrees, -, radii */

/* Rotates a drum at a Froude number; means over the later part of the run. Returns 1 if the run failed. */
static int turn(double froude, int record, turned *out) {
    const double speed = sqrt(froude*g/R);                          /* rad/s */
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.planar = 1;
    desc.thickness = 3e-3;                                          /* m */
    desc.gravity.y = -g;
    desc.dt = 8e-6;                                                 /* s; 0 would choose a shorter step */
    dem_world *world = dem_world_create(&desc);
    dem_material_desc bead_desc = DEM_MATERIAL_DESC;
    bead_desc.density = 2500;                                       /* kg/m3 */
    bead_desc.young = 1.5e7;                                        /* Pa, softened */
    bead_desc.poisson = 0.25;
    bead_desc.restitution = 0.5;
    bead_desc.friction = 0.5;
    bead_desc.rolling_friction = 0.05;
    dem_material bead = dem_material_add(world, &bead_desc);

    /* the shell: a polygon with a lip at each corner, so that the charge does not slide as a whole */
    dem_real corners[4*SIDES];
    int32_t segments[4*SIDES];
    for (int i = 0; i < 2*SIDES; i++) {                             /* i odd: tip of a lip */
        const double angle = pi*(i - i%2)/(double)SIDES;
        corners[2*i] = (R - r*(i%2))*cos(angle);
        corners[2*i + 1] = (R - r*(i%2))*sin(angle);
        segments[2*i] = i - i%2;
        segments[2*i + 1] = i%2 ? i : (i + 2)%(2*SIDES);
    }
    dem_profile shell = {2*SIDES, 2*SIDES, corners, segments};
    dem_wall drum = dem_wall_profile_add(world, bead, &shell, DEM_EDGE_RESOLVED);
    dem_motion turning = DEM_MOTION;
    turning.kind = DEM_MOTION_ROTATING;
    turning.axis = dem_vec3_make(0, 0, 1);
    turning.speed = speed;
    dem_wall_motion_set(world, drum, &turning);
    dem_spheres_fill(world, bead, r, dem_region_make(dem_box_make(-0.03, -0.024, 0, 0.03, 0.024, 0)), 160, 1);

    dem_replay_desc replay_desc = DEM_REPLAY_DESC;
    replay_desc.interval = 0.02;                                    /* s */
    dem_replay *replay = record ? dem_replay_open(world, "08_drum.html", &replay_desc) : 0;
    dem_wall_loads loads;
    double centre[2] = {0, 0}, above = 0, weight = 0;
    for (int i = 0; i < FRAMES; i++) {
        if (i == LATE) { dem_wall_loads_reset(world, drum); dem_overlap_max_reset(world); }
        if (dem_world_run(world, 0.02, 0, 0) != DEM_OK) { puts(dem_world_error_get(world)); return 1; }
        dem_totals t = dem_totals_get(world);
        dem_wall_loads_get(world, drum, &loads);
        dem_replay_value_set(replay, "torque of the drum (mN m)", -1e3*loads.torque_axial);
        dem_replay_value_set(replay, "M g x (mN m)", 1e3*t.mass*g*t.centre[0]);
        weight = t.mass*g;
        if (i < LATE) continue;
        dem_bodies grains = dem_bodies_get(world);
        for (int k = 0; k < grains.count; k++) above += grains.positions[4*k + 1] > 0;   /* y */
        for (int k = 0; k < 2; k++) centre[k] += t.centre[k]/(FRAMES - LATE);
    }
    out->torque = loads.torque_impulse/loads.time;
    out->lever = weight*centre[0];
    out->angle = atan2(centre[0], -centre[1])*180/pi;
    out->above = above/dem_bodies_get(world).count/(FRAMES - LATE);
    out->overlap = dem_counters_get(world).overlap_max;
    dem_replay_close(replay);
    dem_world_destroy(world);
    return 0;
}

int main(int argc, char **argv) {
    const int record = lesson_begin(argc, argv, "08_drum");
    const double froude[4] = {0.01, 0.05, 0.3, 3};
    turned t[4];
    double overlap = 0;
    for (int i = 0; i < 4; i++) {
        if (turn(froude[i], record && i == 1, &t[i])) return 1;
        printf("Fr = %.2f: centre of mass at %3.0f degrees from the vertical\n", froude[i], t[i].angle);
        overlap = fmax(overlap, t[i].overlap);
    }
    for (int i = 0; i < 3; i++) {
        char name[64];
        snprintf(name, sizeof name, "torque at Fr = %.2f, and M g x [mN m]", froude[i]);
        lesson_row(name, -1e3*t[i].torque, 0, 1e3*t[i].lever, 3);
    }
    lesson_range("slope at Fr = 0.01 [degrees]", t[0].angle, 0, 20, 40);
    lesson_range("steeper at Fr = 0.3 by [degrees]", t[2].angle - t[0].angle, 0, 4, 25);
    lesson_range("fraction above the axis, Fr = 0.01", t[0].above, 0, 0, 0.15);
    lesson_row("fraction above the axis, Fr = 3", t[3].above, 0, 0.5, 8);
    lesson_range("largest overlap, at a lip [radii]", overlap, 0, 0, 0.1);
    return lesson_end();
}

/* STOP: answer the question before you read on.
   Theory:    In the steady state the angular momentum of the charge is constant. The torque of the shell therefore
              equals that of the weight, M g x with the horizontal position x of the centre of mass, for any friction.
              Fr is the acceleration at the shell over g. At low Fr the charge rolls down a flat slope at
              its angle of repose; above about 0.1 it cascades; at Fr = 1 gravity at the top provides just the
              centripetal acceleration, and grains that rotate with the shell stay on it (centrifuging).
   Output:    torque = M g x (3 %); slope 20 to 40 degrees at low Fr, more at Fr = 0.3; half above the axis at Fr = 3 */
/* Exercises for ./08_drum --check N VALUE. {2: 1 to 3 by 0.1} is 2 or, for --seed NAME, in that range. */
const char *const exercises[2] = {
    "At how many revolutions per minute does a drum of {1: 0.2 to 4 by 0.1} m diameter begin to centrifuge?",
    "A drum of radius {0.1: 0.05 to 0.3 by 0.01} m is half full. The grains have a mass of {2: 1 to 5 by 0.1} kg and a "
    "slope of {30: 20 to 40 by 1} degrees. What torque rotates the drum, in N m? (The centre of mass of a half disc is "
    "4 R/(3 pi) from its centre.)"};
/* Marking. Stop here if you want to find the answers yourself. */
double answer(int exercise, const double *x) {
    return exercise == 1 ? sqrt(2*g/x[0])*60/(2*pi) : x[1]*g*4*x[0]/(3*pi)*sin(x[2]*pi/180);
}
