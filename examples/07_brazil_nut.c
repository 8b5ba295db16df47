/* 07_brazil_nut.c - lesson 7: segregation by shaking. You learn: a moving wall, impulse on a wall, chance.

   Build:     cc -O2 -o 07_brazil_nut 07_brazil_nut.c ../dem.c -lm      (in the folder examples)
   Run:       ./07_brazil_nut or, with a replay at Gamma = 3, ./07_brazil_nut --replay
   Question:  A large disc lies below small ones of the same density. The box is shaken up and down. Does the large
              disc stay, sink or rise? Does the strength of shaking matter? Write down your answers, then run. */
#include "../dem.h"
#include "lesson.h"

static const double r = 2e-3, big = 7e-3, half = 0.022, g = 9.81, pi = 3.14159265;   /* m; m; m, half the box; m/s2 */

typedef struct shaken { double rise, borne, overlap; } shaken;      /* small diameters; over the weight; radii */

/* Shakes a box at a frequency (Hz) for some periods. Returns 1 if the run failed. */
static int shake(double gamma, double frequency, int periods, int seed, int record, shaken *out) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.planar = 1;
    desc.thickness = 4e-3;                                          /* m */
    desc.gravity.y = -g;
    desc.dt = 7e-6;                                                 /* s, t_c/22; 0 would choose a shorter step */
    dem_world *world = dem_world_create(&desc);
    dem_material_desc bead_desc = DEM_MATERIAL_DESC;
    bead_desc.density = 2500;                                       /* kg/m3, of all discs */
    bead_desc.young = 5e7;                                          /* Pa, softened */
    bead_desc.poisson = 0.25;
    bead_desc.restitution = 0.5;
    bead_desc.friction = 0.4;
    dem_material bead = dem_material_add(world, &bead_desc);

    /* an open box with the large disc on its floor and small ones of two sizes above, at rest after 0.25 s */
    dem_real corners[] = {-half, 0.16, -half, 0, half, 0, half, 0.16};
    int32_t sides[] = {0, 1, 1, 2, 2, 3};                           /* three sides, from corner to corner */
    dem_profile shape = {4, 3, corners, sides};
    dem_wall box = dem_wall_profile_add(world, bead, &shape, DEM_EDGE_RESOLVED);
    dem_body nut = dem_sphere_add(world, bead, big, dem_vec3_make(0, 1.01*big, 0));
    for (int i = 0; i < 2; i++)
        dem_spheres_fill(world, bead, (0.95 + 0.15*i)*r,
                         dem_region_make(dem_box_make(-half, 0, 0, half, 0.11, 0)), 65,
                         (uint64_t)(2*seed + i));
    if (dem_world_run(world, 0.25, 0, 0) != DEM_OK) { puts(dem_world_error_get(world)); return 1; }

    dem_motion up_and_down = DEM_MOTION;                            /* a sine that begins now */
    up_and_down.kind = DEM_MOTION_OSCILLATING;
    up_and_down.velocity.y = 1;                                     /* direction only */
    up_and_down.frequency = frequency;                              /* Hz */
    up_and_down.amplitude = gamma*g/pow(2*pi*frequency, 2);         /* m */
    if (dem_wall_motion_set(world, box, &up_and_down) != DEM_OK) { puts(dem_world_error_get(world)); return 1; }
    dem_wall_loads_reset(world, box);
    dem_overlap_max_reset(world);

    dem_replay_desc replay_desc = DEM_REPLAY_DESC;
    replay_desc.interval = 0.2/frequency;                           /* s */
    dem_replay *replay = record ? dem_replay_open(world, "07_brazil_nut.html", &replay_desc) : 0;
    dem_body_state start, now;
    dem_body_get(world, nut, &start);
    printf("Gamma = %.1f, filling %d, rise every 6 periods [small diameters]:", gamma, seed);
    for (int i = 0; i < periods; i++) {
        for (int k = 0; k < 5; k++) {
            if (dem_world_run(world, 0.2/frequency, 0, 0) != DEM_OK) { puts(dem_world_error_get(world)); return 1; }
            dem_body_get(world, nut, &now);
            dem_replay_value_set(replay, "height of the large disc (mm)", 1e3*now.position.y);
        }
        out->rise = (now.position.y - start.position.y)/(2*r);
        if (i%6 == 5) printf(" %.1f", out->rise);
    }
    dem_wall_loads loads;
    dem_wall_loads_get(world, box, &loads);
    dem_totals after = dem_totals_get(world);
    out->borne = (-loads.impulse[1] - after.momentum[1])/loads.time/(g*after.mass);   /* less the final momentum */
    out->overlap = dem_counters_get(world).overlap_max;
    puts("");
    dem_replay_close(replay);
    dem_world_destroy(world);
    return 0;
}

int main(int argc, char **argv) {
    const int record = lesson_begin(argc, argv, "07_brazil_nut");
    shaken gentle, strong[3];
    double rises[3], borne[3], error, mean, overlap = 0;
    if (shake(0.8, 12, 12, 1, 0, &gentle)) return 1;
    for (int k = 0; k < 3; k++) {
        if (shake(3, 10, 36, k + 1, record && k == 2, &strong[k])) return 1;
        rises[k] = strong[k].rise;
        borne[k] = strong[k].borne;
        overlap = fmax(overlap, strong[k].overlap);
    }
    lesson_range("rise at Gamma = 0.8 [small diameters]", gentle.rise, 0, -0.01, 0.01);
    mean = lesson_mean(rises, 3, &error);
    lesson_range("rise at Gamma = 3 [small diameters]", mean, error, 2, 16);
    mean = lesson_mean(borne, 3, &error);
    lesson_row("mean force over weight, Gamma = 3", mean, 0, 1, 0.2);
    lesson_row("mean force over weight, Gamma = 0.8", gentle.borne, 0, 1, 0.2);
    lesson_range("largest overlap, at the large disc [radii]", overlap, 0, 0, 0.13);
    return lesson_end();
}

/* STOP: answer the question before you read on.
   Theory:    The floor moves as A sin(w t). The heap leaves it only if Gamma = A w^2/g > 1, at sin(w t) = 1/Gamma,
              when the floor accelerates downwards faster than free fall. During the flight small discs slip below
              the large one, never the other way round (Rosato et al., PRL 58 (1987) 1038), and friction at the side
              walls drives convection that carries the middle up. For Gamma < 1 no gap opens. With any shaking the mean
              force of the box equals the weight: the impacts make up for the flights.
   Output:    rise of the large disc in small diameters: 2 to 16 in 3.6 s at Gamma = 3 (mean of three fillings), below
              0.01 at Gamma = 0.8. The mean force equals the weight within 0.2 % */
/* Exercises for ./07_brazil_nut --check N VALUE. {2: 1 to 3 by 0.1} is 2 or, for --seed NAME, in that range. */
const char *const exercises[2] = {
    "The amplitude is {3: 0.5 to 8 by 0.1} mm. Up to which frequency, in Hz, does the heap never leave the floor?",
    "Gamma = {3: 1.5 to 3.2 by 0.1}, {10: 5 to 30 by 1} Hz. How long after passing its middle position upwards does "
    "the floor release the heap, in ms?"};
/* Marking. Stop here if you want to find the answers yourself. */
double answer(int exercise, const double *x) {
    return exercise == 1 ? sqrt(g/(1e-3*x[0]))/(2*pi) : 1e3*asin(1/x[0])/(2*pi*x[1]);
}
