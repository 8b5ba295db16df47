/* 08_drum.c - lesson 8: a drum turns faster and faster.

   Question:  what turns a drum: friction? Does a charge that lies steeper cost more? And from which speed on do grains
              stick to the shell and never fall? Write it down, then run.
   Theory:    steady, nothing of the charge's angular momentum changes: the shell's torque is that of its weight about
              the axis, M g x of its centre of mass, whatever friction is. Speed is told by Froude's number Fr = w^2
              R/g: slowly the charge rolls down a flat slope, at the angle of repose; from about .1 on it cascades; at
              Fr = 1 the weight at the top is just what the circle asks for: all that has come to turn with the shell
              stays on it.
   Build:     cc -O2 08_drum.c ../dem.c -lm
   Run:       08_drum, or 08_drum --replay for a film of Fr = .05 with both torques, 08_drum.html
   Expected:  torque = M g x within 3 %; the centre of mass is turned by 20 to 40 degrees when it rolls, by more at Fr =
              .3; at Fr = 3 half of the grains are above the axis, at .01 hardly any
   Exercises: check with 08_drum --check N VALUE
   1  At how many turns a minute does a drum of 1 m diameter begin to centrifuge?
   2  2 kg half fill a drum of radius .1 m; their slope is 30 degrees. Which torque turns it, in N m? (The centre of a
      half disc is 4 R/(3 pi) from its middle.) */
#include "../dem.h"
#include "lesson.h"

static double answer(int exercise);

enum { SIDES = 24, FRAMES = 80, LATE = 30 };    /* of the shell; of .02 s; from there on means are taken */
static const double R = 0.04, r = 1.5e-3, g = 9.81, pi = 3.14159265;    /* m, of the drum; m, of grains; m/s2 */

typedef struct turned { double torque, lever, angle, above, overlap; } turned;  /* N m, N m, degrees, share, - */

/* A drum at this Froude number: means over the later part of the run; 1: the run broke, and has said why. */
static int turn(double froude, int replay, turned *out) {
    const double speed = sqrt(froude*g/R);                          /* rad/s */
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.planar = 1;
    desc.thickness = 3e-3;                                          /* m */
    desc.gravity.y = -g;
    desc.dt = 8e-6;                                                 /* s; 0: a finer one would be chosen */
    dem_world *world = dem_world_create(&desc);
    dem_material_desc bead_desc = DEM_MATERIAL_DESC;
    bead_desc.density = 2500;                                       /* kg/m3 */
    bead_desc.young = 1.5e7;                                         /* Pa, softened */
    bead_desc.poisson = 0.25;
    bead_desc.restitution = 0.5;
    bead_desc.friction = 0.5;
    bead_desc.rolling_friction = 0.05;
    dem_material bead = dem_material_add(world, &bead_desc);

    /* the shell: a polygon with a lip at each corner, so that the charge cannot slip as a whole */
    dem_real corners[4*SIDES];
    int32_t segments[4*SIDES];
    for (int i = 0; i < 2*SIDES; i++) {                             /* i odd: the tip of a lip */
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
    dem_spheres_fill(world, bead, r,
                     dem_region_make(dem_box_make(-0.03, -0.024, 0, 0.03, 0.024, 0)), 160, 1);

    dem_replay_desc film_desc = DEM_REPLAY_DESC;
    film_desc.interval = 0.02;                                      /* s */
    dem_replay *film = replay ? dem_replay_open(world, "08_drum.html", &film_desc) : 0;
    dem_wall_loads loads;
    double centre[2] = {0, 0}, above = 0, weight = 0;
    for (int i = 0; i < FRAMES; i++) {
        if (i == LATE) { dem_wall_loads_reset(world, drum); dem_overlap_max_reset(world); }
        if (dem_world_run(world, 0.02, 0, 0) != DEM_OK) { puts(dem_world_error_get(world)); return 1; }
        dem_totals t = dem_totals_get(world);
        dem_wall_loads_get(world, drum, &loads);
        dem_replay_value_set(film, "torque that turns it (mN m)", -1e3*loads.torque_axial);
        dem_replay_value_set(film, "M g x (mN m)", 1e3*t.mass*g*t.centre[0]);
        weight = t.mass*g;
        dem_bodies grains = dem_bodies_get(world);
        if (i < LATE) continue;
        for (int k = 0; k < grains.count; k++) above += grains.positions[4*k + 1] > 0;
        for (int k = 0; k < 2; k++) centre[k] += t.centre[k]/(FRAMES - LATE);
    }
    out->torque = loads.torque_impulse/loads.time;
    out->lever = weight*centre[0];
    out->angle = atan2(centre[0], -centre[1])*180/pi;
    out->above = above/dem_bodies_get(world).count/(FRAMES - LATE);
    out->overlap = dem_counters_get(world).overlap_max;
    dem_replay_close(film);
    dem_world_destroy(world);
    return 0;
}

int main(int argc, char **argv) {
    const int replay = lesson_begin(argc, argv, "08_drum", answer);
    const double froude[4] = {0.01, 0.05, 0.3, 3};
    turned t[4];
    double overlap = 0;
    for (int i = 0; i < 4; i++) {
        if (turn(froude[i], replay && i == 1, &t[i])) return 1;
        printf("Fr = %.2f: centre of mass turned by %5.1f degrees\n", froude[i], t[i].angle);
        overlap = fmax(overlap, t[i].overlap);
    }
    for (int i = 0; i < 3; i++) {
        char name[64];
        snprintf(name, sizeof name, "Fr = %.2f: torque beside M g x [mN m]", froude[i]);
        lesson_row(name, -1e3*t[i].torque, 0, 1e3*t[i].lever, 3);
    }
    lesson_range("slope while it rolls, Fr = .01 [degrees]", t[0].angle, 0, 20, 40);
    lesson_range("steeper at Fr = .3 by [degrees]", t[2].angle - t[0].angle, 0, 4, 25);
    lesson_range("above the axis, Fr = .01", t[0].above, 0, 0, 0.15);
    lesson_row("above the axis, Fr = 3: it centrifuges", t[3].above, 0, 0.5, 8);
    lesson_range("largest overlap, at a lip [of the radius]", overlap, 0, 0, 0.1);
    return lesson_end();
}

/* The marking. Stop here if you want to find the answers by yourself. */
static double answer(int exercise) {
    return exercise == 1 ? sqrt(g/0.5)*60/(2*pi) : 2*g*4*0.1/(3*pi)*sin(30*pi/180);
}
