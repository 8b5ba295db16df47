/* 10_clusters.c - lesson 10: grains that are not round: clusters of spheres.

   Question:  tetrahedra of four touching spheres slump from a tube that is taken away; then balls of the same volume
              and material do, which (other than the tetrahedra) even resist rolling. Which heap is steeper, and by how
              much? And how hard is a tetrahedron to spin, compared with a ball of its mass and volume? Write it down,
              then run.
   Theory:    inertia: that of each sphere about itself, 2/5 m r^2, and m a^2 for its centre being off the axis by a. In
              a tetrahedron centres are r sqrt(3/2) from the middle, and by symmetry every axis has 2/3 of that square:
                  I = M r^2 (2/5 + 1)              a ball of its volume: 2/5 M (4^(1/3) r)^2 = 1.008 M r^2
              Of a cone of height H and radius L the mean height is H/4 and the mean distance from the axis L/2.
   Build:     cc -O2 10_clusters.c ../dem.c -lm
   Run:       10_clusters, or 10_clusters --replay for a film of a heap of tetrahedra, 10_clusters.html. 25 times as
              many, until nothing moves: build/heap (examples/heap.c), five minutes
   Expected:  I/(M r^2) = 1.4 within .1 %; tetrahedra are steeper by 3 to 20 degrees, mean of two seeds
   Exercises: check with 10_clusters --check N VALUE
   1  Three touching spheres in a row: I/(M r^2) about an axis across the row? (dem_shape_get confirms it.)
   2  A cone-shaped heap: mean height 3 mm, mean distance from the axis 12 mm. Its slope, in degrees? */
#include "../dem.h"
#include "lesson.h"

static double answer(int exercise);

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
/* Degrees: the slope of a heap; below 0: the run broke. */
static double heap(int tetrahedra, int seed, int replay, double *inertia, double *overlap) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.gravity.z = -9.81;                                         /* m/s2 */
    desc.normal_law = DEM_NORMAL_LINEAR;
    dem_world *world = dem_world_create(&desc);
    dem_material_desc gravel_desc = DEM_MATERIAL_DESC;
    gravel_desc.density = 2500;                                     /* kg/m3 */
    gravel_desc.stiffness = 1200;                                   /* N/m */
    gravel_desc.restitution = 0.3;
    gravel_desc.friction = 0.5;
    gravel_desc.rolling_friction = tetrahedra ? 0 : 0.05;           /* or balls would roll away */
    dem_material gravel = dem_material_add(world, &gravel_desc);
    const dem_vec3 origin = dem_vec3_make(0, 0, 0), up = dem_vec3_make(0, 0, 1);
    dem_plane_add(world, gravel, origin, up);
    dem_wall tube = dem_cylinder_add(world, gravel, origin, up, 0.012, 1);

    dem_shape shape = {0};                                          /* 0: a ball */
    dem_shape_info info;
    if (tetrahedra) {
        shape = tetrahedron(world);
        dem_shape_get(world, shape, &info);
        *inertia = info.inertia.z/(info.volume*r*r);                /* moments per density, hence over volume */
    }
    dem_region inside;
    memset(&inside, 0, sizeof inside);
    inside.box = dem_box_make(-0.012, -0.012, 0, 0.012, 0.012, 0.045);
    inside.cylinder = 'z';
    if (dem_region_fill(world, &inside, gravel, shape, cbrt(4.0)*r, COUNT, (uint64_t)seed) < COUNT) {
        puts(dem_world_error(world));
        return -1;
    }

    dem_replay_desc film_desc = DEM_REPLAY_DESC;
    film_desc.interval = 0.01;                                      /* s */
    dem_replay *film = replay ? dem_replay_open(world, "10_clusters.html", &film_desc) : 0;
    double slope = 0;
    for (int i = 0; i < 55; i++) {
        if (i == 20) dem_wall_remove(world, tube);
        if (dem_world_run(world, 0.01, 0, 0) != DEM_OK) { puts(dem_world_error(world)); return -1; }
        const dem_bodies all = dem_bodies_get(world);
        double high = 0, far = 0;
        for (int k = 0; k < all.count; k++) {
            high += all.positions[4*k + 2] - cbrt(4.0)*r;
            far += hypot(all.positions[4*k], all.positions[4*k + 1]);
        }
        slope = atan(4*high/(2*far))*180/pi;
        dem_replay_value(film, "slope (degrees)", slope);
    }
    *overlap = fmax(*overlap, dem_counters_get(world).overlap_max);
    dem_replay_close(film);
    dem_world_destroy(world);
    return slope;
}

int main(int argc, char **argv) {
    const int replay = lesson_begin(argc, argv, "10_clusters", answer);
    double slope[2][SEEDS], mean[2], error[2], inertia = 0, overlap = 0;
    for (int kind = 0; kind < 2; kind++) {
        for (int seed = 0; seed < SEEDS; seed++) {
            slope[kind][seed] = heap(kind, seed + 1, replay && kind && !seed, &inertia, &overlap);
            if (slope[kind][seed] < 0) return 1;
        }
        mean[kind] = lesson_mean(slope[kind], SEEDS, &error[kind]);
        printf("%-10s: slope %4.1f +- %.1f degrees\n", kind ? "tetrahedra" : "balls", mean[kind], error[kind]);
    }
    lesson_row("a tetrahedron's I/(M r^2)", inertia, 0, 1.4, 0.1);
    lesson_range("its heap is steeper by [degrees]", mean[1] - mean[0], hypot(error[0], error[1]), 3, 20);
    lesson_range("largest overlap [of the radius]", overlap, 0, 0, 0.08);
    return lesson_end();
}

/* The marking. Stop here if you want to find the answers by yourself. */
static double answer(int exercise) { return exercise == 1 ? 0.4 + 2*4/3.0 : atan(4*3/(2*12.0))*180/pi; }
