/* Polyhedra at rest by impulses with the default tolerance: towers, a wall of bricks, a pyramid, an arch, cards that
   lean against each other, heavy blocks on light ones, a block on a slope, and blocks that are poured into a box. With
   time steps up to a tenth of sqrt(size/g) nothing moves that statics keeps at rest. The environment variable TEST_LONG
   has more sizes and time steps, and 1,000 poured blocks. Lengths are in sizes of a block, times in sqrt(size/g). */
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
static place begin(double size, double dt, double slope) {
    place p;
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = scene_stuff(0, 0, friction, 0);
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
static void tower10(const place *p) { tower(p, 10, 0, 0); }
static void tower20(const place *p) { tower(p, 20, 0, 0); }
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

/* kind: 0 cubes, 1 rocks, 2 rods, of about the same volume, which fall into a box without a lid. */
static void poured(const place *p, int kind) {
    const int wide = at_length() ? 10 : 3, high = at_length() ? 10 : 3;
    const double far = wide*1.2*p->size;
    uint64_t seed = 11;
    dem_shape shape[8];
    int i, k, layer;
    for (k = 0; k < 4; k++)
        dem_wall_plane_add(p->world, p->light, at(k & 1 ? far : 0, k & 1 ? far : 0, 0),
                           at(k == 0 ? 1 : k == 1 ? -1 : 0, k == 2 ? 1 : k == 3 ? -1 : 0, 0));
    for (i = 0; i < 8; i++) {
        dem_real x[3*16];
        if (kind != 1) { shape[i] = kind ? box(p, 0.6, 0.6, 2) : box(p, 1, 1, 1); continue; }
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
                               at((i%wide + 0.5)*1.2*p->size, (i/wide + 0.5)*1.2*p->size,
                                  (kind == 2 ? 2.2 : 1.5)*(layer + 0.8)*p->size),
                               dem_quat_make(kind == 2 ? 1 : DEM_R(0.5), axis.x*DEM_R(0.1), axis.y*DEM_R(0.1),
                                             kind == 2 ? 0 : axis.z)).slot);
        }
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
static rest watch(place *p, double settling) {
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
    free(put_at);
    dem_world_destroy(p->world);
    return r;
}

/* most: the largest step; big: 1 if that step is enough for the short form */
typedef struct scene {
    const char *name;
    void (*build)(const place *p);
    double levels, slope, most;
    int big;
} scene;
static const scene scenes[] = {
    {"a tower of 10", tower10, 10, 0, 0.1, 0}, {"a tower of 20", tower20, 20, 0, 0.1, 0},
    {"a tower of 20 with offsets of a hundredth", tower20_offset, 20, 0, 0.1, 1}, {"bricks", bricks, 10, 0, 0.1, 1},
    {"a pyramid", pyramid, 8, 0, 0.1, 1}, {"an arch", arch, 10, 0, 0.1, 0}, {"two cards", cards, 1, 0, 0.1, 0},
    {"heavy on light", heavy_on_light, 6, 0, 0.03, 0}, {"a block on a slope", block, 1, 1, 0.1, 0}
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
                    p = begin(sizes[e], steps[s], o->slope > 0 ? 0.99*atan(friction) : 0);
                    o->build(&p);
                    r = watch(&p, 30);
                    if (getenv("TEST_TABLES"))
                        printf("%-42s size %g m, step %g: fastest %.1e, sinks %.1e, moves %.1e, unsolved %g\n", o->name,
                               sizes[e], steps[s], r.fastest, r.sinks, r.moves, r.unsolved);
                    CHECK(r.fastest < 1e-3);
                    CHECK(r.sinks < fmax(1e-4*o->levels, 0.1*steps[s]*steps[s]));
                    CHECK(r.moves < 0.02);      /* a tower that falls comes to rest, too */
                    CHECK(r.settled);
                }
    }
    TEST("blocks, rocks and rods that are poured into a box come to rest") {
        const char *const names[3] = {"cubes", "rocks", "rods"};
        int kind;
        for (kind = 0; kind < 3; kind++) {
            place p = begin(1, 0.03, 0);
            rest r;
            poured(&p, kind);
            r = watch(&p, 60);
            if (getenv("TEST_TABLES"))
                printf("poured %-35s size 1 m, step 0.03: fastest %.1e, sinks %.1e, unsolved %g\n", names[kind],
                       r.fastest, r.sinks, r.unsolved);
            CHECK(r.fastest < 1e-3);
            CHECK(r.settled);
        }
    }
    return test_end();
}
