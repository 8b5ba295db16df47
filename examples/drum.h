/* drum.h - a drum lined with grains: the wall of particles of the tumbling mill in [MIL], for
   dem_wall_grains_add. MIT licence. Include it after dem.h.

       count = drum_grains(R, L, r, 0, 0);                   their number
       at = (dem_real *)malloc(3*(size_t)count*sizeof *at);
       drum_grains(R, L, r, 0, at);                          their centres
       wall = dem_wall_grains_add(world, material, count, at, r, 1);

   The shell is [MIL] Algorithm 5.2: circles of touching spheres at R - r, in layers r sqrt(3) apart
   along z. Every other layer is rotated by half the distance of its spheres. The ends are Algorithm
   5.3: hexagonal sheets of the spheres of which at least a part is inside the drum's radius. [MIL]
   prints layers at z = -L/2 + r(1 + z sqrt 3), where z itself grows by r sqrt 3; here the number of
   the layer takes the place of that z.
   Tests: tests/api/test_refusals.c. Used by examples/mill.c. */
#ifndef DRUM_H
#define DRUM_H
#include <limits.h>
#include <math.h>
#include <stddef.h>

/* Adds the sheet over the end at z after the first `count` spheres; returns the new number. */
static inline size_t drum_end(double R, double r, double z, size_t count, dem_real *out) {
    const double root3 = sqrt(3.0);
    const int rows = (int)(R/(r*root3)) + 2, columns = (int)(R/(2*r)) + 2;
    int i, j;
    for (j = -rows; j <= rows; j++)
        for (i = -columns; i <= columns; i++) {
            const double x = 2*r*i + (j & 1 ? r : 0), y = r*root3*j;
            if (sqrt(x*x + y*y) >= R + r) continue;
            if (out) {
                out[3*count] = (dem_real)x;
                out[3*count + 1] = (dem_real)y;
                out[3*count + 2] = (dem_real)z;
            }
            count++;
        }
    return count;
}
/* Returns the number of spheres of this radius (m, > 0) that line a drum of drum_radius (m, more than
   2 radii) about z, from z = -length/2 to length/2 (m, > 0), and writes their centres (m, count x 3)
   to out, if it is not null. ends: 1 adds sheets outside both ends, 0 gives the shell only. Returns 0
   if a size is out of its range or not finite, or if more than 5e8 spheres were needed. */
static inline int drum_grains(dem_real drum_radius, dem_real length, dem_real radius, int ends,
                              dem_real *out) {
    const double R = (double)drum_radius, L = (double)length, r = (double)radius;
    const double pi = 3.14159265358979323846, half = asin(r/(R - r)), root3 = sqrt(3.0);
    const double across = 2*R/(r*root3) + 5, round = pi/half;
    const double along = ceil((L - 2*r)/(r*root3)) + 1;
    int layers, circle, i, k;
    size_t count = 0;
    if (!(r > 0 && r < 1e15) || !(R > 2*r && R < 1e15) || !(L > 0 && L < 1e15)) return 0;
    if (!(round*along + (ends ? 2*across*across : 0) < (double)(INT_MAX/4))) return 0;
    circle = (int)round;
    layers = (int)along;
    for (k = 0; k < layers; k++)
        for (i = 0; i < circle; i++, count++) {
            const double angle = 2*pi*i/circle + (k & 1 ? pi/circle : 0);
            if (!out) continue;
            out[3*count] = (dem_real)((R - r)*cos(angle));
            out[3*count + 1] = (dem_real)((R - r)*sin(angle));
            out[3*count + 2] = (dem_real)(-L/2 + r*(1 + k*root3));
        }
    for (k = -1; ends && k <= 1; k += 2) count = drum_end(R, r, k*(L/2 + r), count, out);
    return (int)count;
}
#endif
