/* scene.h - a scene as a list of calls of dem.h, each with the values that differ from the defaults.

   A program draws such lists (draw.h), runs them (run.h), transforms them (relate.h), makes them smaller (shrink.h)
   and prints them as C (print.h). All of this needs to know only what each value is: its type, how it changes when
   the scene is rotated or mirrored (its nature), and its unit as powers of length, mass and time. calls.h has these
   rows. */
#ifndef REL_SCENE_H
#define REL_SCENE_H
#include "../../dem.h"
#include <float.h>
#include <stddef.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { REL_SETS = 32, REL_OPS = 320, REL_POOL = 12000, REL_FEATURES = 320 };

/* The type of a value in the arguments of a call. LIST types are rel_reals and rel_ints, whose numbers are in the
   scene's pool; ARRAY types are arrays inside a desc. PATH: the name of a file, which run.h completes. */
typedef enum rel_type {
    REL_INT, REL_INT3, REL_REAL, REL_DOUBLE, REL_VEC, REL_QUAT, REL_BOX, REL_REF, REL_BODY, REL_REALS, REL_INTS,
    REL_REF_ARRAY, REL_REAL_ARRAY, REL_DOUBLE_ARRAY, REL_CODE, REL_TEXT, REL_PATH, REL_DATA, REL_WHOLE
} rel_type;
/* How a value changes with the axes. IN_BODY: in the frame of a body, changed by mirrors only. TURN: quaternions of
   rotations from a pose. */
typedef enum rel_nature {
    REL_SCALAR, REL_POINT, REL_VECTOR, REL_AXIAL, REL_ORIENTATION, REL_IN_BODY, REL_PER_AXIS, REL_FIXED,
    REL_TURN, REL_TURN_IN_BODY,
    REL_POINT_2, REL_IN_BODY_2, REL_AXES                 /* in the x-y plane; sums of bits of axes */
} rel_nature;
typedef struct rel_field {
    const char *name;
    rel_type type;
    rel_nature nature;
    int length, mass, time;                    /* powers in its unit */
    size_t at;                                 /* offset in the arguments */
} rel_field;
typedef struct rel_reals { int count; dem_real *at; } rel_reals;
typedef struct rel_ints { int count; int32_t *at; } rel_ints;

/* One value. count and at: of lists, in the pool. */
typedef struct rel_set { int field, count, at; double v[6]; } rel_set;
/* A call at a step (0: before the first). References to what it made are its index in the scene. */
typedef struct rel_op { int call, feature, step, count; rel_set set[REL_SETS]; } rel_op;
typedef struct rel_scene {
    uint64_t seed;
    int steps, marks;                          /* marks: how often runs are compared; 0: REL_MARKS times */
    int count, pool_count;
    double unit[2];                            /* length and time of the units of codes.h; 0: m and s */
    unsigned char has[REL_FEATURES];           /* rows of draw.h that it contains */
    double pool[REL_POOL];
    rel_op op[REL_OPS];
} rel_scene;

static void rel_copy(rel_scene *to, const rel_scene *from) {
    memcpy(to, from, offsetof(rel_scene, op) + (size_t)from->count*sizeof *from->op);
}

/* ---- random numbers: splitmix64, the same on every machine ---- */
typedef struct rel_rng { uint64_t s; } rel_rng;
static uint64_t rel_next(rel_rng *r) {
    uint64_t z = (r->s += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30))*0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27))*0x94d049bb133111ebu;
    return z ^ (z >> 31);
}
static int rel_below(rel_rng *r, int n) { return (int)(rel_next(r)%(uint64_t)n); }
/* A number between a and b with few digits, so that printed programs can be read. */
static double rel_between(rel_rng *r, double a, double b) {
    char text[32];
    snprintf(text, sizeof text, "%.3g", a + (b - a)*(double)(rel_next(r) >> 11)*ldexp(1, -53));
    return strtod(text, 0);
}
static int rel_chance(rel_rng *r, double p) { return (double)(rel_next(r) >> 11)*ldexp(1, -53) < p; }
#endif
