/* Polyhedra at rest by impulses with the default tolerance: towers, a wall of bricks, a pyramid, an arch, cards that
   lean against each other, heavy blocks on light ones, a block on a slope, and blocks that are poured into a box. With
   time steps up to a tenth of sqrt(size/g) nothing moves that statics keeps at rest. The environment variable TEST_LONG
   has more sizes and time steps, and 1,000 poured blocks; TEST_TABLES prints what was measured, and TEST_PICTURES, a
   folder, gets a picture of each scene at its end. Lengths are in sizes of a block, times in sqrt(size/g). */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const double g = 9.81, friction = 0.5;   /* m/s2 */
static double length(dem_vec3 v) { return sqrt((double)(v.x*v.x + v.y*v.y + v.z*v.z)); }
static int at_length(void) { return getenv("TEST_LONG") != 0; }

typedef struct place {
    dem_world *world;
    dem_material light, heavy;
    double size, unit, dt;                      /* m; s; s */
} place;
/* slope: the angle of the floor, rad */
static place begin(double size, double dt, double slope, double rolling) {
    place p;
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = scene_stuff(0, 0, friction, rolling);
    p.size = size;
    p.unit = sqrt(size/g);
    desc.gravity = at(g*sin(slope), 0, -g*cos(slope));
    desc.response = DEM_RESPONSE_IMPULSES;
    desc.dt = (dem_real)(p.dt = dt*p.unit);
    desc.threads = 1;
    p.world = dem_world_create(&desc);
    p.light = dem_material_add(p.world, &stuff);
    stuff.density *= 100;
    p.heavy = dem_material_add(p.world, &stuff);
    dem_wall_plane_add(p.world, p.light, at(0, 0, 0), at(0, 0, 1));
    return p;
}
static dem_shape box(const place *p, double a, double b, double c) {
    dem_real x[24];
    scene_box_points(a*p->size, b*p->size, c*p->size, x);
    return dem_shape_polyhedron_add(p->world, 8, x);
}
/* turn: rad, about y */
static void put(const place *p, dem_material of, dem_shape shape, double x, double y, double z, double turn) {
    CHECK(dem_body_add(p->world, of, shape, at(x*p->size, y*p->size, z*p->size),
                       dem_quat_make((dem_real)cos(turn/2), 0, (dem_real)sin(turn/2), 0)).slot);
}
static void tower(const place *p, int blocks, double off, int heavy) {
    const dem_shape cube = box(p, 1, 1, 1);
    int i;
    for (i = 0; i < blocks; i++)
        put(p, heavy && i & 1 ? p->heavy : p->light, cube, off*(i*7%5 - 2), off*(i*3%5 - 2), i + 0.5, 0);
}
/* A cube of eight spheres. */
static dem_shape spheres(const place *p) {
    dem_cluster_desc desc = DEM_CLUSTER_DESC;
    dem_real x[24];
    scene_box_points(0.5*p->size, 0.5*p->size, 0.5*p->size, x);
    desc.count = 8;
    desc.positions = x;
    desc.radius = (dem_real)(0.25*p->size);
    return dem_shape_cluster_add(p->world, &desc);
}
static void tower_mixed(const place *p) {
    const dem_shape shape[2] = {spheres(p), box(p, 1, 1, 1)};
    int i;
    for (i = 0; i < 10; i++) put(p, p->light, shape[i & 1], 0, 0, i + 0.5, 0);
}
static void tower10(const place *p) { tower(p, 10, 0, 0); }
static void tower20(const place *p) { tower(p, 20, 0, 0); }
static void tower50(const place *p) { tower(p, 50, 0, 0); }
static void tower20_offset(const place *p) { tower(p, 20, 0.01, 0); }
static void heavy_on_light(const place *p) { tower(p, 6, 0, 1); }
/* In running bond: rows of bricks of 2 x 1 x 1, every second row with half a brick at either end. */
static void bricks(const place *p) {
    const dem_shape whole = box(p, 2, 1, 1), half = box(p, 1, 1, 1);
    int row, k;
    for (row = 0; row < 10; row++) {
        const int odd = row & 1;
        for (k = 0; k < 10 - odd; k++) put(p, p->light, whole, 2*k + 1 + odd, 0, row + 0.5, 0);
        if (!odd) continue;
        put(p, p->light, half, 0.5, 0, row + 0.5, 0);
        put(p, p->light, half, 19.5, 0, row + 0.5, 0);
    }
}
static void pyramid(const place *p) {
    const dem_shape cube = box(p, 1, 1, 1);
    const int rows = at_length() ? 8 : 4;
    int row, i, j;
    for (row = 0; row < rows; row++)
        for (i = 0; i < rows - row; i++)
            for (j = 0; j < rows - row; j++) put(p, p->light, cube, i + row/2.0, j + row/2.0, row + 0.5, 0);
}
/* A half circle of 21 stones with a thickness of 0.15 of its radius. */
static void arch(const place *p) {
    const double radius = 5, wide = 3.14159265358979/21;
    dem_shape stone;
    dem_real x[24];
    int i;
    for (i = 0; i < 8; i++) {
        const double side = (i & 1 ? 0.5 : -0.5)*wide, r = radius*(i & 4 ? 1.075 : 0.925);
        x[3*i] = (dem_real)(r*sin(side)*p->size);
        x[3*i + 1] = (dem_real)((i & 2 ? 0.5 : -0.5)*p->size);
        x[3*i + 2] = (dem_real)((r*cos(side) - radius)*p->size);
    }
    stone = dem_shape_polyhedron_add(p->world, 8, x);
    for (i = 0; i < 21; i++) {
        const double turn = (i - 10)*wide;
        put(p, p->light, stone, radius*sin(turn), 0, radius*cos(turn), turn);
    }
}
/* Where two cards meet, the face of one is pressed by the edge of the other. They stand if its friction holds them, up to
   an angle whose tangent is the friction: these lean by 0.9 of that. */
static void cards(const place *p) {
    const double thick = 0.02, turn = 0.9*atan(friction);
    const double x = sin(turn)/2 + thick*cos(turn)/2, z = cos(turn)/2 + thick*sin(turn)/2;
    const dem_shape card = box(p, thick, 1, 1);
    put(p, p->light, card, -x, 0, z, turn);
    put(p, p->light, card, x, 0, z, -turn);
}
static void block(const place *p) { put(p, p->light, box(p, 1, 1, 1), 0, 0, 0.5, 0); }

/* kind: 0 cubes, 1 rocks, 2 rods, 3 cubes with ellipsoids and clusters among them, of about the same volume, which fall
   into a box without a lid. */
static void poured(const place *p, int kind) {
    const int wide = at_length() ? 10 : 3, high = at_length() ? 10 : 3;
    const double apart = (kind == 3 ? 1.5 : 1.2)*p->size, far = wide*apart;
    uint64_t seed = 11;
    dem_shape shape[8];
    int i, k, layer;
    for (k = 0; k < 4; k++)
        dem_wall_plane_add(p->world, p->light, at(k & 1 ? far : 0, k & 1 ? far : 0, 0),
                           at(k == 0 ? 1 : k == 1 ? -1 : 0, k == 2 ? 1 : k == 3 ? -1 : 0, 0));
    for (i = 0; i < 8; i++) {
        dem_real x[3*16];
        if (kind == 3 && i%3)
            shape[i] = i%3 == 1 ? spheres(p)
                : dem_shape_ellipsoid_add(p->world, at(0.55*p->size, 0.45*p->size, 0.5*p->size));
        else if (kind != 1) shape[i] = kind == 2 ? box(p, 0.6, 0.6, 2) : box(p, 1, 1, 1);
        if (kind != 1) continue;
        for (k = 0; k < 16; k++) {
            const dem_vec3 u = scene_at(&seed, 2, -1, 2, -1, 2, -1);
            const double l = 0.6*p->size/(length(u) + 1e-9);
            x[3*k] = (dem_real)(l*(double)u.x); x[3*k + 1] = (dem_real)(l*(double)u.y);
            x[3*k + 2] = (dem_real)(l*(double)u.z);
        }
        shape[i] = dem_shape_polyhedron_add(p->world, 16, x);
    }
    for (layer = 0; layer < high; layer++)
        for (i = 0; i < wide*wide; i++) {
            const dem_vec3 axis = scene_at(&seed, 1, 0, 1, 0, 1, 0);
            CHECK(dem_body_add(p->world, p->light, shape[(i + layer)%8],
                               at((i%wide + 0.5)*apart, (i/wide + 0.5)*apart,
                                  (kind == 2 ? 2.2 : 1.5)*(layer + 0.8)*p->size),
                               dem_quat_make(kind == 2 ? 1 : DEM_R(0.5), axis.x*DEM_R(0.1), axis.y*DEM_R(0.1),
                                             kind == 2 ? 0 : axis.z)).slot);
        }
}

/* --- pictures --- */

enum { outline_most = 128, around = 40 };       /* points; of a circle */
typedef struct outline { double x[outline_most], z[outline_most], depth; int count; } outline;
static double left_of(const outline *o, int a, int b, double x, double z) {
    return (o->x[b] - o->x[a])*(z - o->z[a]) - (o->z[b] - o->z[a])*(x - o->x[a]);
}
/* The convex hull in the x-z plane of points x (count x 3), turned by q and moved to p. size: m, of a block. */
static outline outline_of(int count, const dem_real *x, dem_quat q, const dem_real *p, double size) {
    outline all, o;
    int i, k, from = 0, best;
    all.count = count < outline_most ? count : outline_most;
    for (i = 0; i < all.count; i++) {
        const dem_vec3 y = dem_quat_rotate(q, dem_vec3_make(x[3*i], x[3*i + 1], x[3*i + 2]));
        all.x[i] = (double)(p[0] + y.x);
        all.z[i] = (double)(p[2] + y.z);
        if (all.z[i] < all.z[from]) from = i;
    }
    o.depth = (double)p[1];
    for (o.count = 0, k = from; o.count < all.count; k = best) {
        o.x[o.count] = all.x[k];
        o.z[o.count++] = all.z[k];
        for (best = k, i = 0; i < all.count; i++) {
            const double left = left_of(&all, k, best, all.x[i], all.z[i]), tiny = 1e-9*size*size;
            const double far = hypot(all.x[i] - all.x[k], all.z[i] - all.z[k]);
            const double now = hypot(all.x[best] - all.x[k], all.z[best] - all.z[k]);
            if (far > 1e-6*size && (!(now > 1e-6*size) || left < -tiny || (left < tiny && far > now))) best = i;
        }
        if (hypot(all.x[best] - all.x[from], all.z[best] - all.z[from]) < 1e-6*size) break;
    }
    return o;
}
static int nearer(const void *a, const void *b) {
    const double x = ((const outline *)a)->depth, y = ((const outline *)b)->depth;
    return x < y ? 1 : x > y ? -1 : 0;
}
/* Draws a world from the side into TEST_PICTURES/rest_NAME.svg, 300 pixels high. */
static void draw(const place *p, const char *name) {
    const dem_bodies all = dem_bodies_get(p->world);
    outline *o = (outline *)malloc((size_t)(all.count*8 + 1)*sizeof *o);
    double lo = 1e300, hi = -1e300, top = 0;
    char path[300];
    FILE *f;
    int i, k, n = 0;
    snprintf(path, sizeof path, "%s/rest_%s.svg", getenv("TEST_PICTURES"), name);
    for (k = 0; path[k]; k++) if (path[k] == ' ' || path[k] == ',') path[k] = '_';
    for (i = 0; i < all.count; i++) {
        const demi_shape *s = demi_shape_of(p->world, i);
        const dem_quat q = demi_quat_at(p->world->bodies.orient + 4*i);
        if (s->kind == DEMI_POLYHEDRON) {
            dem_real x[3*outline_most];
            for (k = 0; k < 3*s->corners && k < 3*outline_most; k++) x[k] = (dem_real)s->hull[4*s->faces + k];
            o[n++] = outline_of(s->corners, x, q, all.positions + 4*i, p->size);
        } else for (k = 0; k < (s->count ? s->count : 1); k++) {
            /* three circles, or those of the ellipsoid in its planes */
            const dem_real *ball = s->count ? s->parts + 4*k : 0;
            const dem_real r[3] = {ball ? ball[3] : s->axes.x, ball ? ball[3] : s->axes.y, ball ? ball[3] : s->axes.z};
            dem_real x[9*around];
            int e, c;
            memset(x, 0, sizeof x);
            for (e = 0; e < 3*around; e++) {
                const double turn = 6.283185307179586*e/around;
                x[3*e + e/around] = (dem_real)cos(turn)*r[e/around];
                x[3*e + (e/around + 1)%3] = (dem_real)sin(turn)*r[(e/around + 1)%3];
                for (c = 0; c < 3 && ball; c++) x[3*e + c] += ball[c];
            }
            o[n++] = outline_of(3*around, x, q, all.positions + 4*i, p->size);
        }
    }
    for (i = 0; i < n; i++)
        for (k = 0; k < o[i].count; k++) {
            lo = fmin(lo, o[i].x[k]);
            hi = fmax(hi, o[i].x[k]);
            top = fmax(top, o[i].z[k]);
        }
    qsort(o, (size_t)n, sizeof *o, nearer);
    f = fopen(path, "w");
    CHECK(f != 0);
    if (!f) { free(o); return; }
    fprintf(f, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"%.4g %.4g %.4g %.4g\" height=\"300\">\n"
            "<g fill=\"#cfd8e3\" stroke=\"#26374a\" stroke-width=\"%.3g\" stroke-linejoin=\"round\">\n",
            lo - 0.05*top, -1.03*top, hi - lo + 0.1*top, 1.06*top, 0.004*top);
    for (i = 0; i < n; i++) {
        fputs("<path d=\"M", f);
        for (k = 0; k < o[i].count; k++) fprintf(f, "%s%.5g %.5g", k ? "L" : "", o[i].x[k], -o[i].z[k]);
        fputs("z\"/>\n", f);
    }
    fprintf(f, "</g>\n<path d=\"M%.4g 0H%.4g\" stroke=\"#26374a\" stroke-width=\"%.3g\"/>\n</svg>\n", lo - 0.05*top,
            hi + 0.05*top, 0.01*top);
    fclose(f);
    free(o);
}

/* Of a scene that has settled, and is then watched for 190 units: the largest speed of a block, over sqrt(g size); the
   most that a block sinks meanwhile, and the largest distance from where it was put, in sizes; solves that ended early;
   whether dem_world_settle finds the scene at rest. */
typedef struct rest { double fastest, sinks, moves, unsolved; int settled; } rest;
static void places(const dem_world *world, dem_vec3 *x) {
    const dem_bodies all = dem_bodies_get(world);
    int i;
    for (i = 0; i < all.count; i++)
        x[all.slots[i]] = dem_vec3_make(all.positions[4*i], all.positions[4*i + 1], all.positions[4*i + 2]);
}
static rest watch(place *p, double settling, const char *name) {
    const int count = dem_bodies_get(p->world).count;
    const int before = (int)(settling*p->unit/p->dt), steps = (int)(190*p->unit/p->dt);
    dem_vec3 *put_at = (dem_vec3 *)malloc(3*(size_t)count*sizeof *put_at);
    dem_vec3 *settled = put_at + count, *now = settled + count;
    rest r;
    int i, k;
    memset(&r, 0, sizeof r);
    places(p->world, put_at);
    CHECK_EQ(dem_world_step(p->world, before), DEM_OK);
    places(p->world, settled);
    for (k = 0; k < steps && dem_world_step(p->world, 1) == DEM_OK; k++) {
        const dem_bodies all = dem_bodies_get(p->world);
        for (i = 0; i < count; i++) r.fastest = fmax(r.fastest, length(
            dem_vec3_make(all.velocities[4*i], all.velocities[4*i + 1], all.velocities[4*i + 2])));
    }
    CHECK_EQ(k, steps);
    places(p->world, now);
    for (i = 0; i < count; i++) {
        r.sinks = fmax(r.sinks, (double)(settled[i].z - now[i].z)/p->size);
        r.moves = fmax(r.moves, length(dem_vec3_make(now[i].x - put_at[i].x, now[i].y - put_at[i].y,
                                                     now[i].z - put_at[i].z))/p->size);
    }
    r.fastest /= sqrt(g*p->size);
    r.unsolved = (double)dem_counters_get(p->world).unsolved;
    r.settled = dem_world_settle(p->world, (dem_real)(20*p->unit), 0, 0, 0) == DEM_OK;
    if (getenv("TEST_PICTURES")) draw(p, name);
    free(put_at);
    dem_world_destroy(p->world);
    return r;
}

/* most: the largest step; big: 1 if that step is enough for the short form; settling: how long the scene is given to
   come to rest; moves: sizes, more has fallen. The stones of an arch are put 0.009 sizes from where they touch, and
   with the step 0.1 they settle for up to 60 units. */
typedef struct scene {
    const char *name;
    void (*build)(const place *p);
    double levels, slope, most;
    int big;
    double settling, moves;
} scene;
static const scene scenes[] = {
    {"a tower of 10", tower10, 10, 0, 0.1, 0, 30, 0.02},
    {"a tower of 20", tower20, 20, 0, 0.1, 0, 30, 0.02},
    {"a tower of 50", tower50, 50, 0, 0.1, 0, 30, 0.02},
    {"a tower of 20 with offsets of a hundredth", tower20_offset, 20, 0, 0.1, 1, 30, 0.02},
    {"bricks", bricks, 10, 0, 0.1, 1, 30, 0.02},
    {"a pyramid", pyramid, 8, 0, 0.1, 1, 30, 0.02},
    {"an arch", arch, 10, 0, 0.1, 0, 100, 0.05},
    {"two cards", cards, 1, 0, 0.1, 0, 30, 0.02},
    {"a tower of cubes and clusters", tower_mixed, 10, 0, 0.1, 0, 30, 0.02},
    {"heavy on light", heavy_on_light, 6, 0, 0.1, 0, 30, 0.02},
    {"a block on a slope", block, 1, 1, 0.1, 0, 30, 0.02}
};
enum { scene_count = sizeof scenes/sizeof *scenes };

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("blocks that statics keeps at rest do not move, with steps of up to a tenth of sqrt(size/g)") {
        const double steps[3] = {0.1, 0.03, 0.003}, sizes[2] = {1, 1e-3};
        int k, s, e;
        for (k = 0; k < scene_count; k++)
            for (s = 0; s < 3; s++)
                for (e = 0; e < 2; e++) {
                    const scene *o = &scenes[k];
                    place p;
                    rest r;
                    if (steps[s] > o->most || (!at_length() && (e || s == 2 || (s && o->big)))) continue;
                    p = begin(sizes[e], steps[s], o->slope > 0 ? 0.99*atan(friction) : 0, 0);
                    o->build(&p);
                    r = watch(&p, o->settling, o->name);
                    if (getenv("TEST_TABLES"))
                        printf("%-42s size %g m, step %g: fastest %.1e, sinks %.1e, moves %.1e, unsolved %g\n", o->name,
                               sizes[e], steps[s], r.fastest, r.sinks, r.moves, r.unsolved);
                    CHECK(r.fastest < 1e-3);
                    CHECK(r.sinks < fmax(1e-4*o->levels, 0.1*steps[s]*steps[s]));
                    CHECK(r.moves < o->moves);  /* a tower that falls comes to rest, too */
                    CHECK(r.settled);
                }
    }
    TEST("blocks, rocks, rods, ellipsoids and clusters that are poured into a box come to rest") {
        const char *const names[4] = {"cubes", "rocks", "rods", "cubes, ellipsoids, clusters"};
        int kind;
        for (kind = 0; kind < 4; kind++) {
            /* ellipsoids roll to and fro for ever without rolling friction */
            place p = begin(1, 0.03, 0, kind == 3 ? 0.05 : 0);
            rest r;
            poured(&p, kind);
            r = watch(&p, 60, names[kind]);
            if (getenv("TEST_TABLES"))
                printf("poured %-35s size 1 m, step 0.03: fastest %.1e, sinks %.1e, unsolved %g\n", names[kind],
                       r.fastest, r.sinks, r.unsolved);
            CHECK(r.fastest < 1e-3);
            CHECK(r.settled);
        }
    }
    return test_end();
}
