/* lesson.c - a drum, a hopper and a pile of discs that lesson.html runs in a browser, compiled to WebAssembly. As an
   ordinary program it runs the same scenes without pictures: equal sliders and steps give the same digest.

   Build:  make web, and open build/web/lesson.html; or  cc -O2 lesson.c ../../dem.c -lm -o lesson
   Run:    lesson drum|hopper|pile STEPS [GRAINS FRICTION RESTITUTION OWN RATIO]

   Discs, so that every grain is seen: dem.h simulates them as grains of one layer (desc.planar). They are gravel, in a
   drum as wide as a room: scenes so large move no faster than the eye follows. */
#include "../../dem.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef __wasm__
#define LESSON_API(name) __attribute__((export_name(#name)))
#else
#define LESSON_API(name)
#endif

enum { DRUM, HOPPER, PILE, SHELL = 48, LINES = 2*SHELL, NUMBERS = 5 };
static const dem_real pi = 3.14159265358979, g = 9.81;               /* m/s2 */
static dem_real r = 0.02, broad = 1.4;              /* m: mean grain; drum of 2,000 grains */
static void (*change)(dem_world_desc *desc, dem_material_desc *gravel);  /* for other grains, laws: lab.c; or null */

/* one lesson at a time */
static struct {
    dem_world *world;
    int scene;
    dem_real R;                                     /* m: of the drum, and half the width of the others */
    dem_material_desc gravel;
    dem_material material;
    dem_wall moving;                                /* the drum; the walls that are lifted off the pile */
    dem_outlet out;
    float *start, *grains, lines[4*LINES], moved[4*LINES];
    int line_count, still;                          /* of the lines the first `still` do not move */
} now;

static void line_add(dem_real x, dem_real y, dem_real to_x, dem_real to_y) {
    float *l = now.lines + 4*now.line_count++;
    l[0] = (float)x; l[1] = (float)y; l[2] = (float)to_x; l[3] = (float)to_y;
}
/* Adds a wall that consists of the lines since `first`. */
static dem_wall wall_of(int first) {
    dem_real corners[4*LINES];
    int32_t segments[2*LINES];
    dem_profile profile = {0, 0, corners, segments};
    for (int i = first; i < now.line_count; i++) {
        for (int k = 0; k < 4; k++) corners[2*profile.vertex_count + k] = now.lines[4*i + k];
        for (int k = 0; k < 2; k++) segments[2*profile.segment_count + k] = profile.vertex_count++;
        profile.segment_count++;
    }
    return dem_wall_profile_add(now.world, now.material, &profile, DEM_EDGE_RESOLVED);
}
/* A ring with a lip of a grain's radius at every second corner. */
static dem_wall drum_make(void) {
    const dem_real R = now.R;
    for (int i = 0; i < SHELL; i++) {
        const dem_real a = 2*pi*i/SHELL, b = 2*pi*(i + 1)/SHELL;
        line_add(R*cos(a), R*sin(a), R*cos(b), R*sin(b));
        if (i%2) line_add(R*cos(a), R*sin(a), (R - r)*cos(a), (R - r)*sin(a));
    }
    return wall_of(0);
}
/* A silo above a box; mouth: its width in mean diameters of the grains. */
static dem_wall hopper_make(double mouth) {
    const dem_real half = mouth*r, wide = 0.85*now.R;
    for (int side = -1; side < 2; side += 2) {
        line_add(side*wide, 2.2*now.R, side*wide, 0.5*now.R);
        line_add(side*wide, 0.5*now.R, side*half, 0);
        line_add(side*wide, 0, side*wide, -now.R);
    }
    line_add(-wide, -now.R, wide, -now.R);
    return wall_of(0);
}
/* Two walls on a floor. */
static dem_wall pile_make(void) {
    line_add(-3.4*now.R, 0, 3.4*now.R, 0);
    wall_of(0);
    now.still = now.line_count;
    for (int side = -1; side < 2; side += 2) line_add(side*0.6*now.R, 0, side*0.6*now.R, 2*now.R);
    return wall_of(now.still);
}

/* Sets what the sliders change during a run. own: revolutions of the drum per minute, or speed at which the walls of a
   pile are lifted, m/s. Returns 0, or another number after an error: lesson_error has the message. */
LESSON_API(lesson_set) int lesson_set(double friction, double restitution, double own) {
    dem_motion motion = DEM_MOTION;
    now.gravel.friction = friction;
    now.gravel.restitution = restitution;
    if (now.scene == DRUM) {
        motion.kind = DEM_MOTION_ROTATING;
        motion.axis = dem_vec3_make(0, 0, 1);
        motion.speed = own*2*pi/60;
    } else if (now.scene == PILE) {
        motion.kind = DEM_MOTION_TRANSLATING;
        motion.velocity.y = own;
        motion.start = fmax(0, 0.5*sqrt(r/0.02) - dem_world_time_get(now.world));   /* s, when the grains are at rest */
    }
    if (now.scene != HOPPER && dem_wall_motion_set(now.world, now.moving, &motion) != DEM_OK) return 1;
    return dem_material_set(now.world, now.material, &now.gravel) != DEM_OK;
}
/* Where grains may begin: in the drum, off its lips. */
static int inside(dem_vec3 centre, dem_real radius, void *user) {
    (void)user;
    return now.scene != DRUM || sqrt(centre.x*centre.x + centre.y*centre.y) < now.R - r - radius;
}
/* Begins a lesson. own: as above; for the hopper the width of its mouth in mean diameters. ratio, >= 1: radius of large over
   small grains, of which there are equal masses. Returns 0 on success. */
LESSON_API(lesson_begin) int lesson_begin(int scene, int grains, double friction, double restitution, double own,
                                          double ratio) {
    /* the mean mass is that of a grain of radius r; large ones lie below */
    const double large = r*sqrt((ratio*ratio + 1)/2), few = floor(grains/(ratio*ratio + 1));
    const double radius[2] = {large, large/ratio}, count[2] = {few, grains - few};
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_advice advice;

    dem_world_destroy(now.world);
    free(now.start);
    free(now.grains);
    memset(&now, 0, sizeof now);
    now.scene = scene;
    now.R = broad*sqrt(grains/2000.0);
    desc.planar = 1;
    desc.thickness = 2*r;
    desc.gravity.y = -g;
    desc.impact_speed = 1.5;                                            /* m/s */
    now.gravel = DEM_MATERIAL_DESC;
    now.gravel.density = 2600;                                          /* kg/m3 */
    now.gravel.young = 1e8;                                             /* Pa; softened, for longer steps */
    now.gravel.poisson = 0.25;
    now.gravel.friction = friction;
    now.gravel.restitution = restitution;
    now.gravel.rolling_friction = 0.3;                                  /* angular grains */
    if (change) change(&desc, &now.gravel);
    now.world = dem_world_create(&desc);
    now.material = dem_material_add(now.world, &now.gravel);
    now.moving = scene == DRUM ? drum_make() : scene == HOPPER ? hopper_make(own) : pile_make();

    const dem_real R = now.R, wide = scene == DRUM ? R : scene == HOPPER ? 0.84*R : 0.59*R;
    const dem_box room = dem_box_make(-wide, scene == DRUM ? -R : scene == HOPPER ? 0.5*R : 0, 0, wide, 6*R, 0);
    for (int k = 0; k < 2; k++)
        dem_spheres_pack(now.world, now.material, radius[k], 0.02*r,
                         dem_region_inside_make(room, inside, 0), (int)count[k]);
    if (scene != DRUM) {
        dem_outlet_desc below = DEM_OUTLET_DESC;            /* counts in the hopper's box; takes away beside a pile */
        below.box = dem_box_make(-9*R, -9*R, 0, 9*R, -3*r, 0);
        below.keep = scene == HOPPER;
        now.out = dem_outlet_add(now.world, &below);
    }
    now.start = calloc((size_t)grains + 1, sizeof *now.start);
    now.grains = calloc((size_t)grains + 1, NUMBERS*sizeof *now.grains);
    if (!now.start || !now.grains || dem_step_advice_get(now.world, &advice) != DEM_OK) return 1;
    return dem_world_dt_set(now.world, 0.8*advice.dt_max) != DEM_OK || lesson_set(friction, restitution, own);
}
/* Takes steps. Sliders may set contacts for which the time step is too long (a low restitution is a strong dashpot). Then the
   time step becomes shorter and the steps continue. */
LESSON_API(lesson_step) int lesson_step(int steps) {
    const uint64_t end = dem_world_steps_get(now.world) + (uint64_t)steps;
    dem_result result = DEM_OK;
    for (int i = 0; i < 20 && dem_world_steps_get(now.world) < end; i++) {
        result = dem_world_step(now.world, (int)(end - dem_world_steps_get(now.world)));
        if (result == DEM_OK || result != DEM_ERROR_TIME_STEP) break;
        if (dem_world_dt_set(now.world, 0.7*dem_world_desc_get(now.world).dt) != DEM_OK) break;
    }
    return result != DEM_OK;
}
LESSON_API(lesson_steps) double lesson_steps(void) { return (double)dem_world_steps_get(now.world); }
LESSON_API(lesson_time) double lesson_time(void) { return dem_world_time_get(now.world); }
LESSON_API(lesson_hash) uint64_t lesson_hash(void) { return dem_world_hash_get(now.world); }
LESSON_API(lesson_error) const char *lesson_error(void) { return dem_world_error_get(now.world); }
LESSON_API(lesson_overlap) double lesson_overlap(void) { return dem_counters_get(now.world).overlap_max; }
LESSON_API(lesson_count) int lesson_count(void) { return dem_bodies_get(now.world).count; }
/* lesson_count x 5: x, y, radius [m], speed [m/s], and the position at the first call as a number from about 0 to 1
   (in the drum from left to right, otherwise upwards). */
LESSON_API(lesson_grains) const float *lesson_grains(void) {
    const dem_bodies all = dem_bodies_get(now.world);
    for (int i = 0; i < all.count; i++) {
        const dem_real *x = all.positions + 4*i, *v = all.velocities + 4*i;
        float *to = now.grains + NUMBERS*i, *start = now.start + all.slots[i];
        if (!(*start > 0))
            *start = (float)(now.scene == DRUM ? 0.5 + x[0]/(2*now.R) :
                             now.scene == HOPPER ? x[1]/now.R - 0.5 : x[1]/(1.5*now.R));
        to[0] = (float)x[0]; to[1] = (float)x[1]; to[2] = (float)x[3];
        to[3] = (float)sqrt(v[0]*v[0] + v[1]*v[1]); to[4] = *start;
    }
    return now.grains;
}
LESSON_API(lesson_line_count) int lesson_line_count(void) { return now.line_count; }
/* lesson_line_count x 4: x, y of both ends [m] of the lines of the walls, at present. */
LESSON_API(lesson_lines) const float *lesson_lines(void) {
    dem_pose pose;
    memcpy(now.moved, now.lines, sizeof now.moved);
    if (dem_wall_pose_get(now.world, now.moving, &pose) != DEM_OK) return now.moved;
    for (int i = 2*now.still; i < 2*now.line_count; i++) {
        const float *x = now.lines + 2*i;
        now.moved[2*i] = (float)(pose.position.x + pose.rotation[0]*x[0] + pose.rotation[1]*x[1]);
        now.moved[2*i + 1] = (float)(pose.position.y + pose.rotation[3]*x[0] + pose.rotation[4]*x[1]);
    }
    return now.moved;
}
/* Returns the slope in drum or pile [degrees], below -90 if there is none yet, or the number of grains out of the hopper. */
LESSON_API(lesson_measure) double lesson_measure(void) {
    const dem_box all = {{0, 0, 0}, {0, 0, 0}};
    dem_repose slope;
    dem_outlet_state out;
    if (now.scene == HOPPER) return dem_outlet_get(now.world, now.out, &out) == DEM_OK ? (double)out.total : 0;
    if ((now.scene == DRUM ? dem_repose_drum_get(now.world, all, dem_vec3_make(0, 0, 1), &slope)
                           : dem_repose_heap_get(now.world, all, &slope)) != DEM_OK) return -100;
    return slope.angle*180/pi;
}

#ifndef __wasm__
int main(int argc, char **argv) {
    static const char *names[3] = {"drum", "hopper", "pile"};
    static const double own[3] = {10, 8, 0.3};
    double v[6] = {0, 1000, 0.5, 0.5, 0, 1.4};                          /* the first values of the sliders */
    int scene = 0;
    while (argc > 1 && scene < 3 && strcmp(argv[1], names[scene])) scene++;
    if (argc < 3 || scene == 3) {
        fputs("usage: lesson drum|hopper|pile STEPS [GRAINS FRICTION RESTITUTION OWN RATIO]\n", stderr);
        return 1;
    }
    v[4] = own[scene];
    for (int i = 2; i < argc && i < 8; i++) v[i - 2] = atof(argv[i]);
    if (lesson_begin(scene, (int)v[1], v[2], v[3], v[4], v[5]) || lesson_step((int)v[0])) {
        fprintf(stderr, "%s\n", lesson_error());
        return 1;
    }
    printf("%s, %d grains, step %.0f, time %.4f s, overlap %.3f, measure %.2f: digest %016llx\n", names[scene],
           lesson_count(), lesson_steps(), lesson_time(), lesson_overlap(), lesson_measure(),
           (unsigned long long)lesson_hash());
    return 0;
}
#endif
