/* pairs.c - what one pair of convex polyhedra costs, by corners: touching, face on face, apart. MIT licence.

   build/pairs             seconds; results in build/out/pairs

   Each turn looks at 4000 pairs in random orientations once, so that none is known from before. Times are of the
   processor; lengths of the radius R of the sphere of the polyhedron's volume.
   touching  at corners, edges and faces as they come, pushed together by .001 R from where they begin to touch
   flat      a face on a face, off its middle, by .001 R
   apart     by 0 to .05 R, as a list of neighbours has them; told: those that a face keeps apart at the first look
   Springs ask what two share; gaps are what impulses, and laws with a range, ask for: cold from the direction between
   the centres, warm from the normal of the step before, in which one had turned by .01 rad less. */
#define DEM_IMPLEMENTATION
#include "dem.h"
#include "examples/study.h"
#include "bench/measure.h"

enum { PAIRS = 4000, TURNS = 9, KINDS = 3 };
static struct { demi_part p, q; dem_vec3 gap, normal; } pairs[PAIRS];
static uint64_t seed = 11;

/* All orientations are equally likely. */
static dem_quat orientation(void) {
    const double u = demi_uniform(&seed), a = 2*DEMI_PI*demi_uniform(&seed), b = 2*DEMI_PI*demi_uniform(&seed);
    const double r = sqrt(1 - u), s = sqrt(u);
    return dem_quat_make((dem_real)(r*sin(a)), (dem_real)(r*cos(a)), (dem_real)(s*sin(b)), (dem_real)(s*cos(b)));
}
static dem_vec3 direction(void) { return dem_quat_rotate(orientation(), dem_vec3_make(0, 0, 1)); }
static double between(double a, double b) { return a + (b - a)*demi_uniform(&seed); }
/* A cube, or the hull of points on a sphere, no two of them near each other. */
static dem_shape hull(dem_world *w, int corners) {
    dem_real x[3*64];
    int i, k, tries;
    if (corners == 8) for (i = 0; i < 24; i++) x[i] = (dem_real)(i/3 >> i%3 & 1 ? 0.5 : -0.5);
    else for (i = 0; i < corners; i++) {
        double best = -1;
        for (tries = 0; tries < 50; tries++) {
            const dem_vec3 e = direction();
            double least = 4;
            for (k = 0; k < i; k++) least = fmin(least, (double)demi_length(demi_sub(e, demi_at(x + 3*k))));
            if (!(least > best)) continue;
            best = least;
            x[3*i] = e.x; x[3*i + 1] = e.y; x[3*i + 2] = e.z;
        }
    }
    return dem_shape_polyhedron_add(w, corners, x);
}
static int meet(const dem_world *w, int i, dem_vec3 gap) {
    demi_persistent c;
    memset(&c, 0, sizeof c);
    return demi_polyhedra_touch(w, &pairs[i].p, &pairs[i].q, gap, 0, &c, 0);
}
/* The gap of pair i up to .1 of a radius; from: the normal to begin with, or 0; it comes back as the pair's. */
static int gap_of(dem_world *w, int i, double size, dem_vec3 from, dem_vec3 *normal) {
    demi_persistent c;
    demi_spots spots;
    memset(&c, 0, sizeof c);
    c.normal = from;
    spots.count = 0;
    w->margin.reach = 0.1*size;
    if (!demi_polyhedra_near(w, &pairs[i].p, &pairs[i].q, pairs[i].gap, &c, &spots)) return 0;
    *normal = c.normal;
    return 1;
}
static dem_vec3 normal_of(const demi_part *p, int face) { /* unit, in the world                         */
    const double *a = p->shape->hull + 4*face;
    return dem_quat_rotate(p->q, dem_vec3_make((dem_real)(a[0]*a[3]), (dem_real)(a[1]*a[3]), (dem_real)(a[2]*a[3])));
}
/* Face on face: q is turned so that its face looks at p's. */
static void lay(int i, double size) {
    demi_part *p = &pairs[i].p, *q = &pairs[i].q;
    const int f = (int)between(0, p->shape->faces), g = (int)between(0, q->shape->faces);
    const dem_vec3 n = normal_of(p, f), m = demi_scale(normal_of(q, g), -1), aside = demi_cross(n, direction());
    const double cosine = (double)demi_dot(m, n);
    dem_quat turn;
    if (cosine < -0.999) { lay(i, size); return; }
    turn = demi_quat_again(dem_quat_make((dem_real)(1 + cosine), demi_cross(m, n).x, demi_cross(m, n).y, demi_cross(m, n).z));
    q->q = dem_quat_multiply(turn, q->q);
    pairs[i].gap = demi_add(demi_scale(n, (dem_real)(p->shape->hull[4*f + 3] + q->shape->hull[4*g + 3] - 1e-3*size)),
                            demi_scale(aside, (dem_real)(0.1*size)));
}
static void pair_make(const dem_world *w, int i, int kind, double size) {
    dem_vec3 e = direction();
    double in = 0, off = 4*size;
    int k;
    pairs[i].p = demi_part_now(w, 0, 0);
    pairs[i].q = demi_part_now(w, 1, 0);
    pairs[i].p.q = orientation();
    pairs[i].q.q = orientation();
    if (kind == 1) { lay(i, size); return; }
    in = size*0.5;
    for (k = 0; k < 50; k++) {
        const double half = (in + off)/2;
        *(meet(w, i, demi_scale(e, (dem_real)half)) ? &in : &off) = half;
    }
    pairs[i].gap = demi_scale(e, (dem_real)(kind ? off + between(0, 0.05)*size : in - 1e-3*size));
}
/* ns a pair, cold and warm. */
static void measure_gaps(dem_world *w, int corners, const char *kind, double size) {
    const dem_quat turn = dem_quat_about(dem_vec3_make((dem_real)0.6, 0, (dem_real)0.8), (dem_real)0.01);
    double times[TURNS];
    char name[64];
    int i, k, warm, found = 0;
    for (i = 0; i < PAIRS; i++) {
        const dem_quat now = pairs[i].q.q;
        pairs[i].normal = dem_vec3_make(0, 0, 0);
        pairs[i].q.q = dem_quat_multiply(turn, now);
        gap_of(w, i, size, pairs[i].normal, &pairs[i].normal);
        pairs[i].q.q = now;
    }
    for (warm = 0; warm < 2; warm++) {
        for (k = 0; k < TURNS; k++) {
            const clock_t begun = clock();
            for (i = 0; i < PAIRS; i++) {
                dem_vec3 normal;
                found += gap_of(w, i, size, warm ? pairs[i].normal : dem_vec3_make(0, 0, 0), &normal);
            }
            times[k] = 1e9*(double)(clock() - begun)/CLOCKS_PER_SEC/PAIRS;
        }
        snprintf(name, sizeof name, "pairs.%d.%s.gap_%s", corners, kind, warm ? "warm" : "cold");
        bench_result_short(name, bench_median(times, TURNS), "ns");
    }
    snprintf(name, sizeof name, "pairs.%d.%s.gap_found", corners, kind);
    bench_result_short(name, 100.0*found/PAIRS/TURNS/2, "%");
}
static void measure(int corners) {
    static const char *const kinds[] = {"touching", "flat", "apart"};
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc m = DEM_MATERIAL_DESC;
    dem_world *w = dem_world_create(&desc), *rigid;
    dem_material stuff;
    dem_shape_info info;
    dem_shape shape;
    double times[TURNS], size;
    char name[64];
    int kind, i, k;
    desc.response = DEM_RESPONSE_IMPULSES;
    desc.dt = (dem_real)1e-3;
    rigid = dem_world_create(&desc);
    m.density = 1000;
    m.young = (dem_real)1e7;
    m.restitution = (dem_real)0.5;
    stuff = dem_material_add(w, &m);
    shape = hull(w, corners);
    if (dem_shape_get(w, shape, &info) != DEM_OK || info.corners != corners) { study_fail("%s", dem_world_error_get(w)); return; }
    size = cbrt(3*(double)info.volume/(4*DEMI_PI));
    dem_body_add(w, stuff, shape, dem_vec3_make(0, 0, 0), dem_quat_make(1, 0, 0, 0));
    dem_body_add(w, stuff, shape, dem_vec3_make(9, 0, 0), dem_quat_make(1, 0, 0, 0));
    snprintf(name, sizeof name, "pairs.%d.faces", corners);
    bench_result_short(name, info.faces, "");
    for (kind = 0; kind < KINDS; kind++) {
        int found = 0, told = 0;
        for (i = 0; i < PAIRS; i++) pair_make(w, i, kind, size);
        for (k = 0; k < TURNS; k++) {
            const clock_t begun = clock();
            for (i = 0; i < PAIRS; i++) found += meet(w, i, pairs[i].gap);
            times[k] = 1e9*(double)(clock() - begun)/CLOCKS_PER_SEC/PAIRS;
        }
        for (i = 0; i < PAIRS; i++)
            told += demi_face_keeps(&pairs[i].p, &pairs[i].q, pairs[i].gap) ||
                demi_face_keeps(&pairs[i].q, &pairs[i].p, demi_scale(pairs[i].gap, -1));
        snprintf(name, sizeof name, "pairs.%d.%s", corners, kinds[kind]);
        bench_result_short(name, bench_median(times, TURNS), "ns");
        snprintf(name, sizeof name, "pairs.%d.%s.spread", corners, kinds[kind]);
        bench_result_short(name, bench_spread(times, TURNS), "%");
        snprintf(name, sizeof name, "pairs.%d.%s.found", corners, kinds[kind]);
        bench_result_short(name, 100.0*found/PAIRS/TURNS, "%");
        measure_gaps(rigid, corners, kinds[kind], size);
        if (kind != 2) continue;
        snprintf(name, sizeof name, "pairs.%d.%s.told", corners, kinds[kind]);
        bench_result_short(name, 100.0*told/PAIRS, "%");
    }
    dem_world_destroy(rigid);
    dem_world_destroy(w);
}
int main(int argc, char **argv) {
    static const char *out = "build/out/pairs";
    static const study_option table[] = {{"out", STUDY_TEXT, &out, 0, 0, "", "folder of results"}};
    study_options(argc, argv, "What one pair of convex polyhedra costs.", table, 1);
    study_begin(out);
    bench_machine();
    measure(8);
    measure(14);
    measure(50);
    return study_end();
}
