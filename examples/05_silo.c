/* 05_silo.c - lesson 5: a tube is filled higher and higher. Does its floor carry all the weight?

   Question:  beads in a tube, up to three diameters high. Water twice as high presses twice as hard. And beads? Draw
              the floor's load against the height, then run.
   Theory:    Janssen 1895: where beads rub against the wall, a slice passes part of its weight on to it. With the
              sideways pressure K times the vertical one and friction mu fully called upon, for bulk density rho_b the
              floor bears
                  W = rho_b g (pi D^2/4) lambda (1 - exp(-H/lambda)),  lambda = D/(4 mu K),
              the weight of a column one lambda high, and not more. Friction points upwards only when beads move down
              along the wall; beads that bounced in may be wedged any way. So the tube is drawn up slowly, all the time.
   Build:     cc -O2 05_silo.c ../dem.c -lm
   Run:       05_silo, or 05_silo --replay for a film of the highest column with its loads, 05_silo.html
   Expected:  floor and wall together bear the weight within 1 %; one K, between .3 and 1, gives
              the loads of all four heights within 12 %; the floor of the highest column bears a third of its weight
   Exercises: check with 05_silo --check N VALUE
   1  D = 1 m, rho_b = 800 kg/m3 (wheat), K = .5, mu = .3. Double the friction: what does the floor of an endlessly
      high silo bear then, in N?
   2  At which H/D does the floor bear half of the weight, if mu = .4 and K = .5? */
#include "../dem.h"
#include "lesson.h"

static double answer(int exercise);

enum { HEIGHTS = 4, SEEDS = 3 };
static const double R = 2e-3, D = 24e-3, mu = 0.4, g = 9.81, pi = 3.14159265;   /* m, of beads, of the tube; -; m/s2 */

typedef struct column { double height, floor, wall, weight, overlap; } column;   /* m, N, N, N, of the radius */

static double janssen(double rho_b, double K, double H) {
    const double lambda = D/(4*mu*K);
    return rho_b*g*pi*D*D/4*lambda*(1 - exp(-H/lambda));
}
/* So many beads into the tube, at rest; 1: the run broke, and has said why. */
static int fill(int count, int seed, int replay, column *out) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.gravity.z = -g;
    dem_world *world = dem_world_create(&desc);
    dem_material_desc glass_desc = DEM_MATERIAL_DESC;
    glass_desc.density = 2500;                                      /* kg/m3 */
    glass_desc.young = 6e6;                                         /* Pa, softened */
    glass_desc.poisson = 0.25;
    glass_desc.restitution = 0.3;
    glass_desc.friction = mu;
    dem_material glass = dem_material_add(world, &glass_desc);
    dem_vec3 origin = dem_vec3_make(0, 0, 0), up = dem_vec3_make(0, 0, 1);
    dem_wall floor = dem_wall_plane_add(world, glass, origin, up), tube = dem_wall_cylinder_add(world, glass, origin, up, D/2, 1);
    dem_motion drawn = DEM_MOTION;
    drawn.kind = DEM_MOTION_TRANSLATING;
    drawn.velocity.z = 0.01;                                        /* m/s */
    dem_wall_motion_set(world, tube, &drawn);
    dem_box box = dem_box_make(-D/2, -D/2, 0, D/2, D/2, 0.006 + count*3e-4);   /* of it, what is in the tube */
    if (dem_spheres_fill(world, glass, R, dem_region_make(box), count, (uint64_t)seed) < count) puts(dem_world_error_get(world));

    dem_replay_desc film_desc = DEM_REPLAY_DESC;
    film_desc.interval = 0.005;                                     /* s */
    dem_replay *film = replay ? dem_replay_open(world, "05_silo.html", &film_desc) : 0;
    dem_wall_loads below, around;
    for (int i = 0; i < 70; i++) {                                  /* means from .25 s on: all is at rest */
        if (i == 50) dem_overlap_max_reset(world), dem_wall_loads_reset(world, floor), dem_wall_loads_reset(world, tube);
        if (dem_world_run(world, 0.005, 0, 0) != DEM_OK) { puts(dem_world_error_get(world)); return 1; }
        dem_wall_loads_get(world, floor, &below);
        dem_wall_loads_get(world, tube, &around);
        dem_replay_value_set(film, "floor bears (N)", -below.force.z);
        dem_replay_value_set(film, "wall bears (N)", -around.force.z);
    }
    dem_totals totals = dem_totals_get(world);
    out->height = 2*totals.centre[2];                               /* twice that of the centre of mass */
    out->floor = -below.impulse[2]/below.time;                      /* means of many steps: one step may ring */
    out->wall = -around.impulse[2]/around.time;
    out->weight = g*totals.mass;
    out->overlap = dem_counters_get(world).overlap_max;
    dem_replay_close(film);
    dem_world_destroy(world);
    return 0;
}

int main(int argc, char **argv) {
    const int replay = lesson_begin(argc, argv, "05_silo", answer), count[HEIGHTS] = {75, 150, 300, 450};
    double height[HEIGHTS], weight[HEIGHTS], load[HEIGHTS], error[HEIGHTS], worst = 0, overlap = 0;
    for (int i = 0; i < HEIGHTS; i++) {
        double loads[SEEDS];
        height[i] = weight[i] = 0;
        for (int seed = 0; seed < SEEDS; seed++) {                  /* every filling is another: hence error bars */
            column c;
            if (fill(count[i], seed + 1, replay && i == HEIGHTS - 1 && !seed, &c)) return 1;
            loads[seed] = c.floor;
            height[i] += c.height/(double)SEEDS;
            weight[i] += c.weight/(double)SEEDS;
            worst = fmax(worst, fabs((c.floor + c.wall)/c.weight - 1));
            overlap = fmax(overlap, c.overlap);
        }
        load[i] = lesson_mean(loads, SEEDS, &error[i]);
    }
    const double rho_b = weight[HEIGHTS - 1]/(g*pi*D*D/4*height[HEIGHTS - 1]);  /* kg/m3, bulk density */
    double K = 0, least = 1e300;
    for (double k = 0.1; k < 1.5; k += 0.001) {                     /* least squares: one K for all heights */
        double sum = 0;
        for (int i = 0; i < HEIGHTS; i++) sum += pow(load[i] - janssen(rho_b, k, height[i]), 2);
        if (sum < least) { least = sum; K = k; }
    }
    for (int i = 0; i < HEIGHTS; i++) {
        char name[64];
        snprintf(name, sizeof name, "H/D = %.2f, %.4f N: floor bears [N]", height[i]/D, weight[i]);
        lesson_row(name, load[i], error[i], janssen(rho_b, K, height[i]), 12);
    }
    lesson_range("K, sideways over vertical pressure", K, 0, 0.3, 1);
    lesson_range("floor's share of the highest column", load[HEIGHTS - 1]/weight[HEIGHTS - 1], 0, 0.2, 0.45);
    lesson_range("floor and wall miss of the weight, at most", worst, 0, 0, 0.01);
    lesson_range("largest overlap [of the radius]", overlap, 0, 0, 0.05);
    return lesson_end();
}

/* The marking. Stop here if you want to find the answers by yourself. */
static double answer(int exercise) {
    double s = 1;                                                   /* H/lambda: (1 - exp(-s))/s = 1/2 */
    for (int i = 0; i < 60; i++) s = 2*(1 - exp(-s));
    return exercise == 1 ? 800*9.81*pi/4*1/(4*0.6*0.5) : s/(4*0.4*0.5);
}
