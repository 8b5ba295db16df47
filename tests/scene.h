/* scene.h - small worlds that several tests build. Include after dem.h and test.h.
   SI units; `at` and the like take doubles, so that a scene reads the same in both precisions. */
#ifndef SCENE_H
#define SCENE_H
/* Scenes have the same numbers in all calls, also where a compiler inlines some and could fuse products and sums. */
#if defined(__GNUC__) && !defined(__clang__) && !defined(__TINYC__)
#pragma GCC optimize("fp-contract=off")
#endif
#include <stdlib.h>

static inline dem_vec3 at(double x, double y, double z) {
    return dem_vec3_make((dem_real)x, (dem_real)y, (dem_real)z);
}
static inline dem_box box_of(double x0, double y0, double z0, double x1, double y1, double z1) {
    dem_box box;
    box.lo = at(x0, y0, z0);
    box.hi = at(x1, y1, z1);
    return box;
}
/* 0 <= number < 1, of a generator with its own state (splitmix64) */
static inline double scene_random(uint64_t *state) {
    uint64_t z = (*state += UINT64_C(0x9E3779B97F4A7C15));
    z = (z ^ (z >> 30))*UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27))*UINT64_C(0x94D049BB133111EB);
    return (double)((z ^ (z >> 31)) >> 11)/9007199254740992.0;
}
/* Three of them, in the order of the axes whatever the compiler: a u + b along each. */
static inline dem_vec3 scene_at(uint64_t *state, double ax, double bx, double ay, double by, double az,
                                double bz) {
    const double x = ax*scene_random(state) + bx, y = ay*scene_random(state) + by;
    const double z = az*scene_random(state) + bz;
    return at(x, y, z);
}
static inline dem_material_desc scene_stuff(double young, double restitution, double friction,
                                            double rolling) {
    dem_material_desc m = DEM_MATERIAL_DESC;
    m.density = 2500;
    m.young = (dem_real)young;
    m.poisson = DEM_R(0.25);
    m.restitution = (dem_real)restitution;
    m.friction = (dem_real)friction;
    m.rolling_friction = (dem_real)rolling;
    return m;
}
static inline dem_material scene_material(dem_world *world, double young, double restitution,
                                          double friction, double rolling) {
    dem_material_desc m = scene_stuff(young, restitution, friction, rolling);
    return dem_material_add(world, &m);
}
static inline dem_body_state scene_state(const dem_world *world, dem_body body) {
    dem_body_state s;
    memset(&s, 0, sizeof s);
    dem_body_get(world, body, &s);
    return s;
}
static inline void scene_move(dem_world *world, dem_body body, dem_vec3 velocity, dem_vec3 spin) {
    dem_body_state s = scene_state(world, body);
    s.velocity = velocity;
    s.spin = spin;
    dem_body_set(world, body, &s);
}
#ifndef DEM_NO_REPORTS
/* The report contains these words. */
static inline void scene_report_has(const dem_world *world, const char *words) {
    static char text[16000];
    FILE *f = tmpfile();
    CHECK(f != 0);
    if (!f) return;
    dem_world_report(world, f);
    rewind(f);
    text[fread(text, 1, sizeof text - 1, f)] = 0;
    fclose(f);
    CHECK_STR(text, words);
}
#endif
/* A box of these edges, m, its corner i with the bits of i as signs. */
static inline void scene_box_points(double a, double b, double c, dem_real *p) {
    int i;
    for (i = 0; i < 8; i++) {
        p[3*i] = (dem_real)(i & 1 ? a/2 : -a/2);
        p[3*i + 1] = (dem_real)(i & 2 ? b/2 : -b/2);
        p[3*i + 2] = (dem_real)(i & 4 ? c/2 : -c/2);
    }
}
#ifndef DEM_NO_POLYHEDRA
static inline dem_shape scene_box(dem_world *world, double a, double b, double c) {
    dem_real p[24];
    scene_box_points(a, b, c, p);
    return dem_shape_polyhedron_add(world, 8, p);
}
/* The hull of points on an ellipsoid of semi-axes size, .8 size and .6 size, m. */
static inline dem_shape scene_rock(dem_world *world, uint64_t *state, int count, double size) {
    dem_real p[300];
    int i;
    for (i = 0; i < count; i++) {
        const double z = 2*scene_random(state) - 1, f = 6.283185307179586*scene_random(state);
        const double s = sqrt(1 - z*z);
        p[3*i] = (dem_real)(size*s*cos(f));
        p[3*i + 1] = (dem_real)(0.8*size*s*sin(f));
        p[3*i + 2] = (dem_real)(0.6*size*z);
    }
    return dem_shape_polyhedron_add(world, count, p);
}
#endif
static inline dem_quat scene_turn(uint64_t *state) {
    const dem_vec3 axis = scene_at(state, 2, -1, 2, -1, 2, -1);
    return dem_quat_about(axis, (dem_real)(6*scene_random(state)));
}
#if defined(DEM_IMPLEMENTATION) && !defined(DEM_NO_POLYHEDRA)
/* A polyhedron as contacts see it, of its own size and turned. */
static inline demi_part scene_part(const dem_world *world, dem_shape shape, dem_quat q) {
    demi_part p;
    memset(&p, 0, sizeof p);
    p.kind = DEMI_POLYHEDRON;
    p.shape = &world->shapes[shape.id - 1];
    p.scale = 1;
    p.radius = p.shape->radius;
    p.q = q;
    return p;
}
/* The distance of points all over a polyhedron's faces from what `off` measures, least of all, m. */
static inline double scene_sampled(const demi_solid *s, double (*off)(const double *x)) {
    const int32_t *loops = s->rim + s->faces + 1;
    double least = 1e300;
    int f, i, j, e;
    for (f = 0; f < s->faces; f++)
        for (e = s->rim[f] + 1; e + 1 < s->rim[f + 1]; e++)
            for (i = 0; i <= 60; i++)
                for (j = 0; j <= 60 - i; j++) {
                    demi_d3 sum = demi_d3_scale(s->corner[loops[s->rim[f]]], i);
                    double x[3];
                    sum = demi_d3_plus(sum, j, s->corner[loops[e]]);
                    sum = demi_d3_plus(sum, 60 - i - j, s->corner[loops[e + 1]]);
                    demi_d3_put(x, demi_d3_over(sum, 60));
                    least = fmin(least, off(x));
                }
    return least;
}
#endif
/* Steps and says why when that fails. */
static inline dem_result scene_step(dem_world *world, int steps) {
    const dem_result result = dem_world_step(world, steps);
    if (result != DEM_OK) puts(dem_world_error_get(world));
    return result;
}

/* An allocator that counts, refuses one request, hands out rubbish and leaves rubbish behind. */
typedef struct scene_memory {
    long calls, blocks, wrong;                 /* requests so far, blocks out, wrong sizes on free */
    size_t bytes, most;                        /* out, and at most so far */
    long refuse;                               /* this request gets nothing; 0: none */
    int refused;
} scene_memory;
enum { SCENE_FRONT = 32 };                     /* bytes in front of a block; keeps the alignment */
static inline void *scene_alloc(size_t size, void *user) {
    scene_memory *m = (scene_memory *)user;
    char *p;
    m->calls++;
    if (m->calls == m->refuse) { m->refused = 1; return 0; }
    p = (char *)malloc(size + SCENE_FRONT);
    if (!p) return 0;
    memcpy(p, &size, sizeof size);
    memset(p + SCENE_FRONT, 0xA5, size);       /* whoever counts on zeros finds none */
    m->blocks++;
    m->bytes += size;
    if (m->bytes > m->most) m->most = m->bytes;
    return p + SCENE_FRONT;
}
static inline void scene_free(void *memory, size_t size, void *user) {
    scene_memory *m = (scene_memory *)user;
    char *p = (char *)memory - SCENE_FRONT;
    size_t was;
    if (!memory) return;
    memcpy(&was, p, sizeof was);
    m->wrong += was != size;
    m->blocks--;
    m->bytes -= was;
    memset(p, 0x5A, was + SCENE_FRONT);        /* whoever looks again finds rubbish */
    free(p);
}
/* From here on a world of this desc takes its memory from there. */
static inline void scene_memory_use(scene_memory *m, dem_world_desc *desc) {
    memset(m, 0, sizeof *m);
    desc->allocator.alloc_fn = scene_alloc;
    desc->allocator.free_fn = scene_free;
    desc->allocator.user = m;
}

/* A lattice of grains that overlap slightly, radii within 3 % of each other (mixed) or all alike,
   with random velocities of up to `speed`: contacts everywhere from the first step on. */
static inline dem_result scene_block(dem_world *world, dem_material material, int nx, int ny,
                                     int nz,
                                     double radius, int mixed, double speed, uint64_t seed) {
    const int count = nx*ny*nz;
    const double pitch = 1.97*radius;
    dem_real *x = (dem_real *)malloc((size_t)count*7*sizeof(dem_real));
    dem_real *v = x + 3*count, *r = x + 6*count;
    dem_result result;
    int i, k;
    if (!x) return DEM_ERROR_MEMORY;
    for (i = 0; i < count; i++) {
        x[3*i] = (dem_real)(pitch*(i%nx) + radius);
        x[3*i + 1] = (dem_real)(pitch*(i/nx%ny) + radius);
        x[3*i + 2] = (dem_real)(pitch*(i/nx/ny) + radius);
        for (k = 0; k < 3; k++) v[3*i + k] = (dem_real)(speed*(2*scene_random(&seed) - 1));
        r[i] = (dem_real)(radius*(mixed ? 0.97 + 0.06*scene_random(&seed) : 1));
    }
    result = dem_spheres_add(world, material, count, x, v, r, 0);
    free(x);
    return result;
}

/* A mesh of nx by ny quads of two triangles each from (x0, y0) to (x1, y1) at z = 0. */
static inline dem_wall scene_floor(dem_world *world, dem_material material, double x0, double y0,
                                   double x1, double y1, int nx, int ny) {
    const int points = (nx + 1)*(ny + 1);
    dem_mesh mesh;
    dem_wall wall;
    int i, j, n = 0;
    wall.id = 0;
    mesh.vertex_count = points;
    mesh.triangle_count = 2*nx*ny;
    mesh.vertices = (dem_real *)malloc((size_t)points*3*sizeof(dem_real));
    mesh.triangles = (int32_t *)malloc((size_t)mesh.triangle_count*3*sizeof(int32_t));
    if (mesh.vertices && mesh.triangles) {
        for (j = 0; j <= ny; j++)
            for (i = 0; i <= nx; i++) {
                dem_real *p = mesh.vertices + 3*(i + (nx + 1)*j);
                p[0] = (dem_real)(x0 + (x1 - x0)*i/nx);
                p[1] = (dem_real)(y0 + (y1 - y0)*j/ny);
                p[2] = 0;
            }
        for (j = 0; j < ny; j++)
            for (i = 0; i < nx; i++) {
                const int32_t a = i + (nx + 1)*j, b = a + 1, c = a + nx + 1, d = c + 1;
                int32_t *t = mesh.triangles + 3*n;
                t[0] = a; t[1] = b; t[2] = d;
                t[3] = a; t[4] = d; t[5] = c;
                n += 2;
            }
        wall = dem_wall_mesh_add(world, material, &mesh);
    }
    free(mesh.vertices);
    free(mesh.triangles);
    return wall;
}

/* A drum about an axis along z through (x, y), as a profile of n segments. */
static inline dem_wall scene_drum(dem_world *world, dem_material material, double x, double y,
                                  double radius, int n) {
    dem_real vertices[2*128];
    int32_t segments[2*128];
    dem_profile profile;
    int i;
    for (i = 0; i < n; i++) {
        vertices[2*i] = (dem_real)(x + radius*cos(6.283185307179586*i/n));
        vertices[2*i + 1] = (dem_real)(y + radius*sin(6.283185307179586*i/n));
        segments[2*i] = i;
        segments[2*i + 1] = (i + 1)%n;
    }
    profile.vertex_count = profile.segment_count = n;
    profile.vertices = vertices;
    profile.segments = segments;
    return dem_wall_profile_add(world, material, &profile, DEM_EDGE_RESOLVED);
}
#endif
