/* screen.c - a vibrating screen that slopes down: which fraction of each size passes, and how many grains blind it.
   Build: cc -O2 -I. -o screen examples/screen.c dem.c -lm       Run: ./screen

   A plate with square holes of 6 mm oscillates along its normal with an amplitude of 1 mm at 25 Hz. It slopes by 0.25 rad.
   The axes slope with it, so gravity has a component along x. Each grain of the feed passes, leaves at the lower end or is
   still there, and the counts add up. No grain larger than a hole passes. Smaller grains pass in larger fractions. */
#include "dem.h"
#include <math.h>

enum { SIZES = 4, EACH = 200 };
int main(void) {
    const double L = 0.45, W = 0.04, slope = 0.25;                                          /* m, m, rad */
    const dem_world_desc desc = {.gravity = {9.81*sin(slope), 0, -9.81*cos(slope)}, .domain = {{-1, 0, -1}, {1, W, 1}},
        .boundary = {DEM_BOUNDARY_OPEN, DEM_BOUNDARY_PERIODIC}};                            /* a strip of a wide screen */
    const dem_material_desc gravel = {.density = 2500, .young = 5e6, .restitution = 0.4, .friction = 0.5, .rolling_friction = 0.05};
    const dem_motion shaking = {.kind = DEM_MOTION_OSCILLATING, .velocity = {0, 0, 1}, .amplitude = 1e-3, .frequency = 25};
    const dem_sieve_desc plate = {.kind = DEM_SIEVE_SQUARE, .aperture = 6e-3, .bar = 2e-3};
    dem_world *world = dem_world_create(&desc);
    const dem_material stone = dem_material_add(world, &gravel);
    const dem_wall screen = dem_wall_sieve_add(world, stone, &plate);
    dem_wall_motion_set(world, screen, &shaking);
    const dem_feed_desc feed = {.material = stone, .class_count = SIZES, .radius = {1.8e-3, 2.4e-3, 2.8e-3, 3.3e-3}, .limited = 1,
        .amount = {EACH, EACH, EACH, EACH}, .rate = 200, .box = {{0.01, 0, 0.01}, {0.04, W, 0.02}}};    /* m, grains/s */
    dem_feed_add(world, &feed);
    dem_outlet_desc below = {.box = {{-1, 0, -1}, {L, W, -0.006}}, .class_count = SIZES}, end = {.box = {{L, 0, -1}, {1, W, 1}}, .class_count = SIZES};
    for (int c = 0; c < SIZES; c++) below.radius[c] = end.radius[c] = feed.radius[c];
    const dem_outlet under = dem_outlet_add(world, &below), over = dem_outlet_add(world, &end);
    if (dem_world_run(world, 8, dem_progress_print, stderr) != DEM_OK) { puts(dem_world_error_get(world)); return 1; }
    dem_outlet_state u, o;
    dem_outlet_get(world, under, &u), dem_outlet_get(world, over, &o);
    const int left = dem_bodies_get(world).count, blind = dem_sieve_blinded_get(world, screen, 0);
    puts("radius (mm)   passed   at the end");
    for (int c = 0; c < SIZES; c++) printf("%11.1f %8.3f %12.3f\n", 1e3*feed.radius[c], (double)u.count[c]/EACH, (double)o.count[c]/EACH);
    printf("%d of %d grains are left, %d of them in holes\n", left, SIZES*EACH, blind);
    dem_world_destroy(world);
    return u.count[3] || u.count[0] < u.count[2] || u.total + o.total + (unsigned)left != SIZES*EACH;
}
