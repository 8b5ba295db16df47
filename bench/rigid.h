/* rigid.h - the heaps that bench/rigid.sh pours in dem.h, Bullet and ODE. MIT licence. C99 and C++.

   1,000 bodies fall into a box of 12 x 12 m, open above: balls with a radius of 0.5 m, cubes with edges of 1 m, or eight
   kinds of rocks, hulls of 12 to 19 points on ellipsoids of about 1 m. Density 2500 kg/m3, friction 0.5, restitution 0,
   steps of 10 ms. After 4 s in which the heap comes to rest, 200 steps are timed. The result is one line:

       raw SECONDS CONTACTS KINETIC HEIGHT SWEEPS OTHER         // J/kg, mean of v^2/2; m, mean of the centres
*/
#ifndef BENCH_RIGID_H
#define BENCH_RIGID_H
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define RIGID_SIDE 12.0         /* m */
#define RIGID_DT 0.01           /* s */
#define RIGID_DENSITY 2500.0    /* kg/m3 */
#define RIGID_FRICTION 0.5
enum { RIGID_BALLS, RIGID_BLOCKS, RIGID_ROCKS, RIGID_ROW = 9, RIGID_KINDS = 8, RIGID_POINTS = 19, RIGID_SETTLE = 400,
       RIGID_TIMED = 200 };

typedef struct rigid_heap {
    int shape, count, most;     /* most: sweeps or iterations of a step; 0: the default of the code */
    uint64_t seed;
} rigid_heap;
static double rigid_random(rigid_heap *h) {
    h->seed = h->seed*UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(h->seed >> 11)/9007199254740992.0;
}
/* Arguments: balls_rigid, blocks_rigid or rocks_rigid; number of bodies; most sweeps; seed. */
static rigid_heap rigid_begin(int argc, char **argv) {
    rigid_heap h;
    const char *name = argc > 1 ? argv[1] : "blocks_rigid";
    h.shape = name[0] == 'r' ? RIGID_ROCKS : name[1] == 'a' ? RIGID_BALLS : RIGID_BLOCKS;
    h.count = argc > 2 ? atoi(argv[2]) : 1000;
    h.most = argc > 3 ? atoi(argv[3]) : 0;
    h.seed = argc > 4 ? (uint64_t)atoi(argv[4]) : 1;
    return h;
}
/* Points of kind k of the bodies, m, about no particular centre. Returns their number; 0 for balls. */
static int rigid_points(const rigid_heap *of, int k, double *x) {
    rigid_heap h = *of;
    const int count = 12 + k;
    int i, e;
    if (of->shape == RIGID_BALLS) return 0;
    if (of->shape == RIGID_BLOCKS) {
        for (i = 0; i < 24; i++) x[i] = i/3 >> i%3 & 1 ? 0.5 : -0.5;
        return 8;
    }
    h.seed = 1000 + (uint64_t)k;
    for (i = 0; i < count; i++) {
        double u[3], l = 0;
        for (e = 0; e < 3; e++) { u[e] = 2*rigid_random(&h) - 1; l += u[e]*u[e]; }
        for (e = 0; e < 3; e++) x[3*i + e] = (0.5 + 0.1*e)*u[e]/sqrt(l + 1e-12);
    }
    return count;
}
/* Place of the next body, i: layers of 9 x 9, with some disorder. */
static void rigid_place(rigid_heap *h, int i, double *x) {
    const int layer = RIGID_ROW*RIGID_ROW;
    x[0] = 1.5 + 1.12*(i%RIGID_ROW) + 0.1*rigid_random(h);
    x[1] = 1.5 + 1.12*(i/RIGID_ROW%RIGID_ROW) + 0.1*rigid_random(h);
    x[2] = 0.8 + 1.25*(i/layer) + 0.05*rigid_random(h);
}
/* Walls k = 0 to 4: inward normal and n.x of their points. */
static void rigid_wall(int k, double *n, double *at) {
    const double all[5][4] = {{0, 0, 1, 0}, {1, 0, 0, 0}, {-1, 0, 0, -RIGID_SIDE}, {0, 1, 0, 0}, {0, -1, 0, -RIGID_SIDE}};
    memcpy(n, all[k], 3*sizeof *n);
    *at = all[k][3];
}
static double rigid_seconds(void) { return (double)clock()/CLOCKS_PER_SEC; }
/* other: of dem.h the number of unsolved steps, of the others the size of a real, byte */
static void rigid_tell(const rigid_heap *h, double seconds, double contacts, double kinetic, double height, double sweeps,
                       int other) {
    printf("raw %.9g %.6g %.6g %.6g %.4g %d\n", seconds, contacts, kinetic/h->count, height/h->count, sweeps, other);
}
#endif
