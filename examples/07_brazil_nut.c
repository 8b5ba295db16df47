/* 07_brazil_nut.c - lesson 7: a big disc under small ones, in a box that is shaken.

   Question:  the big disc weighs as much per area as the small ones. Shake the box up and down: does it stay, sink or
              rise? Does any shaking do it, if only long enough? Write it down, then run.
   Theory:    a floor at A sin(w t) falls faster than free fall when A w^2 > g: only if Gamma = A w^2/g > 1 does the
              heap leave the floor, at sin(w t) = 1/Gamma. While all fly, small ones slip under the big one, never the
              other way round (Rosato et al., PRL 58 (1987) 1038); and walls that rub carry the middle up. Below Gamma =
              1 nothing opens. Whatever the shaking, the floor bears the weight on average: what it gives as it hits, it
              saves as they fly.
   Build:     cc -O2 07_brazil_nut.c ../dem.c -lm
   Run:       07_brazil_nut, or 07_brazil_nut --replay for a film of Gamma = 3 with the height of the big disc,
              07_brazil_nut.html
   Expected:  at Gamma = 3 it comes up by 2 to 16 small diameters in 3.6 s, mean of three fillings; at .8 it stays, to a
              hundredth of one; the box bears the weight within .2 %, once the momentum that the heap has at the end is
              taken off
   Exercises: check with 07_brazil_nut --check N VALUE
   1  The floor's amplitude is 3 mm. Up to which frequency, in Hz, does nothing ever leave it?
   2  Gamma = 3, 10 Hz. How long after passing its middle, upwards, does the floor let the heap go, in ms? */
#include "../dem.h"
#include "lesson.h"

static double answer(int exercise);

static const double r = 2e-3, big = 7e-3, half = 0.022, g = 9.81, pi = 3.14159265;   /* m; m; m, half the box; m/s2 */

typedef struct shaken { double rise, borne, overlap; } shaken;      /* small diameters; of the weight; of the radius */

/* Shakes a box at so many Hz for so many periods; 1: the run broke, and has said why. */
static int shake(double gamma, double frequency, int periods, int seed, int replay, shaken *out) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.planar = 1;
    desc.thickness = 4e-3;                                          /* m */
    desc.gravity.y = -g;
    desc.dt = 7e-6;                                                 /* s, t_c/22; 0: a finer one would be chosen */
    dem_world *world = dem_world_create(&desc);
    dem_material_desc bead_desc = DEM_MATERIAL_DESC;
    bead_desc.density = 2500;                                       /* kg/m3, of all discs */
    bead_desc.young = 5e7;                                          /* Pa, softened */
    bead_desc.poisson = 0.25;
    bead_desc.restitution = 0.5;
    bead_desc.friction = 0.4;
    dem_material bead = dem_material_add(world, &bead_desc);

    /* a box open at the top, the big disc on its floor, small ones of two sizes above it, at rest after .25 s */
    dem_real corners[] = {-half, 0.16, -half, 0, half, 0, half, 0.16};
    int32_t sides[] = {0, 1, 1, 2, 2, 3};
    dem_profile shape = {4, 3, corners, sides};
    dem_wall box = dem_wall_profile_add(world, bead, &shape, DEM_EDGE_RESOLVED);
    dem_body nut = dem_sphere_add(world, bead, big, dem_vec3_make(0, 1.01*big, 0));
    for (int i = 0; i < 2; i++)
        dem_spheres_fill(world, bead, (0.95 + 0.15*i)*r,
                         dem_region_make(dem_box_make(-half, 0, 0, half, 0.11, 0)), 65,
                         (uint64_t)(2*seed + i));
    if (dem_world_run(world, 0.25, 0, 0) != DEM_OK) { puts(dem_world_error_get(world)); return 1; }

    dem_motion up_and_down = DEM_MOTION;                            /* a sine of the time since it was set */
    up_and_down.kind = DEM_MOTION_OSCILLATING;
    up_and_down.velocity.y = 1;                                     /* only its direction counts */
    up_and_down.frequency = frequency;                              /* Hz */
    up_and_down.amplitude = gamma*g/pow(2*pi*frequency, 2);         /* m */
    if (dem_wall_motion_set(world, box, &up_and_down) != DEM_OK) { puts(dem_world_error_get(world)); return 1; }
    dem_wall_loads_reset(world, box);
    dem_overlap_max_reset(world);

    dem_replay_desc film_desc = DEM_REPLAY_DESC;
    film_desc.interval = 0.2/frequency;                             /* s */
    dem_replay *film = replay ? dem_replay_open(world, "07_brazil_nut.html", &film_desc) : 0;
    dem_body_state start, now;
    dem_body_get(world, nut, &start);
    printf("Gamma = %.1f, seed %d, small diameters that it has risen:", gamma, seed);
    for (int i = 0; i < periods; i++) {
        for (int k = 0; k < 5; k++) {
            if (dem_world_run(world, 0.2/frequency, 0, 0) != DEM_OK) { puts(dem_world_error_get(world)); return 1; }
            dem_body_get(world, nut, &now);
            dem_replay_value_set(film, "height of the big disc (mm)", 1e3*now.position.y);
        }
        out->rise = (now.position.y - start.position.y)/(2*r);
        if (i%6 == 5) printf(" %.1f", out->rise);
    }
    dem_wall_loads loads;
    dem_wall_loads_get(world, box, &loads);
    dem_totals after = dem_totals_get(world);
    out->borne = (-loads.impulse[1] - after.momentum[1])/loads.time/(g*after.mass);   /* at first all was at rest */
    out->overlap = dem_counters_get(world).overlap_max;
    puts("");
    dem_replay_close(film);
    dem_world_destroy(world);
    return 0;
}

int main(int argc, char **argv) {
    const int replay = lesson_begin(argc, argv, "07_brazil_nut", answer);
    shaken gentle, strong[3];
    double rises[3], borne[3], error, mean, overlap = 0;
    if (shake(0.8, 12, 12, 1, 0, &gentle)) return 1;
    for (int k = 0; k < 3; k++) {
        if (shake(3, 10, 36, k + 1, replay && k == 2, &strong[k])) return 1;
        rises[k] = strong[k].rise;
        borne[k] = strong[k].borne;
        overlap = fmax(overlap, strong[k].overlap);
    }
    lesson_range("Gamma = .8: it rises [small diameters]", gentle.rise, 0, -0.01, 0.01);
    mean = lesson_mean(rises, 3, &error);
    lesson_range("Gamma = 3: it rises [small diameters]", mean, error, 2, 16);
    mean = lesson_mean(borne, 3, &error);
    lesson_row("Gamma = 3: the box bears, of the weight", mean, error, 1, 0.2);
    lesson_row("Gamma = .8: the box bears", gentle.borne, 0, 1, 0.2);
    lesson_range("largest overlap, under the big disc", overlap, 0, 0, 0.13);
    return lesson_end();
}

/* The marking. Stop here if you want to find the answers by yourself. */
static double answer(int exercise) {
    return exercise == 1 ? sqrt(g/0.003)/(2*pi) : 1e3*asin(1.0/3)/(2*pi*10);
}
