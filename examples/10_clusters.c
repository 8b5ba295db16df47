/* 10_clusters.c - lesson 10: grains that are not round. You learn: clusters, moments of inertia, interlocking.

   Build:     cc -O2 -o 10_clusters 10_clusters.c ../dem.c -lm      (in the folder examples)
   Run:       ./10_clusters or, with a replay of a heap of tetrahedra, ./10_clusters --replay. `make build/heap` builds
              the long form (heap.c): 25 times as many grains until all rest, five minutes
   Question:  Tetrahedra of four touching spheres collapse after the tube around them is removed. Balls of the same
              volume and material do the same; only the balls have rolling resistance. Which heap is steeper? Which has
              the larger moment of inertia, a tetrahedron or a ball of its mass and volume? Write it down, then run. */
#include "../dem.h"
#include "lesson.h"

enum { COUNT = 80, SEEDS = 2 };
static const double r = 1e-3, pi = 3.14159265;                      /* m, of the spheres of a tetrahedron */

/* Four touching spheres at the corners of a tetrahedron. */
static dem_shape tetrahedron(dem_world *world) {
    const double a = r/sqrt(2.0);
    const dem_real centres[12] = {a, a, a, a, -a, -a, -a, a, -a, -a, -a, a};
    dem_cluster_desc desc = DEM_CLUSTER_DESC;
    desc.count = 4;
    desc.positions = centres;
    desc.radius = r;
    return dem_shape_cluster_add(world, &desc);
}
/* Returns the slope of a heap (degrees); -1: the run failed. */
static double heap(int tetrahedra, int seed, int record, double *inertia, double *overlap) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.gravity.z = -9.81;                                         /* m/s2 */
    desc.normal_law = DEM_NORMAL_LINEAR;
    dem_world *world = dem_world_create(&desc);
    dem_material_desc gravel_desc = DEM_MATERIAL_DESC;
    gravel_desc.density = 2500;                                     /* kg/m3 */
    gravel_desc.stiffness = 1200;                                   /* N/m */
    gravel_desc.restitution = 0.3;
    gravel_desc.friction = 0.5;
    gravel_desc.rolling_friction = tetrahedra ? 0 : 0.05;           /* otherwise balls roll away */
    dem_material gravel = dem_material_add(world, &gravel_desc);
    const dem_vec3 origin = dem_vec3_make(0, 0, 0), up = dem_vec3_make(0, 0, 1);
    dem_wall_plane_add(world, gravel, origin, up);
    dem_wall tube = dem_wall_cylinder_add(world, gravel, origin, up, 0.012, 1);   /* m; 1: grains are inside */

    dem_region inside = dem_region_make(dem_box_make(-0.012, -0.012, 0, 0.012, 0.012, 0.045));
    int placed;
    inside.cylinder = 'z';
    if (tetrahedra) {
        const dem_shape shape = tetrahedron(world);
        dem_shape_info info;
        placed = dem_bodies_fill(world, gravel, shape, inside, COUNT, (uint64_t)seed);
        dem_shape_get(world, shape, &info);
        *inertia = info.inertia.z/(info.volume*r*r);                /* moments are per density */
    } else placed = dem_spheres_fill(world, gravel, cbrt(4.0)*r, inside, COUNT, (uint64_t)seed);
    if (placed < COUNT) { puts(dem_world_error_get(world)); return -1; }

    dem_replay_desc replay_desc = DEM_REPLAY_DESC;
    replay_desc.interval = 0.01;                                    /* s */
    dem_replay *replay = record ? dem_replay_open(world, "10_clusters.html", &replay_desc) : 0;
    double slope = 0;
    for (int i = 0; i < 55; i++) {
        if (i == 20) dem_wall_remove(world, tube);
        if (dem_world_run(world, 0.01, 0, 0) != DEM_OK) { puts(dem_world_error_get(world)); return -1; }
        const dem_bodies all = dem_bodies_get(world);
        double high = 0, far = 0;
        for (int k = 0; k < all.count; k++) {
            high += all.positions[4*k + 2] - cbrt(4.0)*r;           /* x, y, z, radius of grain k */
            far += hypot(all.positions[4*k], all.positions[4*k + 1]);
        }
        slope = atan(4*high/(2*far))*180/pi;
        dem_replay_value_set(replay, "slope (degrees)", slope);
    }
    *overlap = fmax(*overlap, dem_counters_get(world).overlap_max);
    dem_replay_close(replay);
    dem_world_destroy(world);
    return slope;
}

int main(int argc, char **argv) {
    const int record = lesson_begin(argc, argv, "10_clusters");
    double slope[2][SEEDS], mean[2], error[2], inertia = 0, overlap = 0;
    for (int kind = 0; kind < 2; kind++) {
        for (int seed = 0; seed < SEEDS; seed++) {
            slope[kind][seed] = heap(kind, seed + 1, record && kind && !seed, &inertia, &overlap);
            if (slope[kind][seed] < 0) return 1;
        }
        mean[kind] = lesson_mean(slope[kind], SEEDS, &error[kind]);
    }
    lesson_row("I/(M r^2) of a tetrahedron", inertia, 0, 1.4, 0.1);
    lesson_range("slope of balls [degrees]", mean[0], error[0], 1, 25);
    lesson_range("slope of tetrahedra [degrees]", mean[1], error[1], 5, 30);
    lesson_claim("tetrahedra are steeper than balls by 3 degrees or more", mean[1] > mean[0] + 3);
    lesson_range("largest overlap [radii]", overlap, 0, 0, 0.08);
    return lesson_end();
}

/* STOP: answer the question before you read on.
   Theory:    Each sphere of mass m contributes 2/5 m r^2 about its own centre, plus m a^2 if its centre is a off the
              axis. The centres are sqrt(3/2) r from the middle; by symmetry the mean a^2 is 2/3 of that squared, r^2.
              So  I = (2/5 + 1) M r^2;   a ball of the same volume: 2/5 M (4^(1/3) r)^2 = 1.008 M r^2
              A cone of height H and radius L has the mean height H/4 and the mean distance L/2 from its axis.
   Output:    I/(M r^2) = 1.4 within 0.1 %; tetrahedra are steeper by 3 degrees or more (mean of two runs) */
/* Exercises for ./10_clusters --check N VALUE. {2: 1 to 3 by 0.1} is 2 or, for --seed NAME, in that range. */
const char *const exercises[2] = {
    "What is I/(M r^2) of {3: 2 to 12 by 1} touching spheres in a row, about an axis through the middle of the row and "
    "across it? (dem_shape_get confirms it.)",
    "A cone of grains has the mean height {3: 2 to 4 by 0.1} mm and the mean distance {12: 10 to 20 by 0.5} mm from "
    "its axis. What is its slope in degrees?"};
/* Marking. Stop here if you want to find the answers yourself. */
double answer(int exercise, const double *x) {
    return exercise == 1 ? 0.4 + (x[0]*x[0] - 1)/3 : atan(4*x[0]/(2*x[1]))*180/pi;
}
