/* Elastic impacts where two pieces of a surface touch: every body on every kind of joint, by
   springs and by impulses. No body may leave with more energy than it brought, beyond the error of
   the step. By springs that error is the largest gain of the same body, at the same step, on one
   plane. By impulses it is the largest gain in free flight, because an impact is solved exactly.
   A world has many lanes. In each a body is thrown at a joint again and again, without gravity and
   friction. TEST_LONG makes more than a million impacts and prints the largest gain of each cell,
   as TEST_TABLES does. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const double R = 2e-3, pi = 3.141592653589793;        /* m, half the size of a body */
static const double half = 12e-3, pitch = 30e-3;  /* m, of the surface of a lane; between lanes */
static int at_length(void) { return getenv("TEST_LONG") != 0; }
static int tables(void) { return at_length() || getenv("TEST_TABLES"); }

enum { BALL, CLUMP, ELLIPSOID, CUBE, ROCK, UNION, DISC, POLYGON, BODIES };
static const char *const body_name[BODIES] = {"ball", "clump", "ellipsoid", "cube", "rock",
                                              "union", "disc", "polygon"};
enum { PLANE, PLANES, MESHES, PROFILES, BOXES, JUNCTIONS, FOLDS, SLIVERS, DOUBLED, PERIODIC, BELTS,
       BLOCKS, SURFACES };
static const char *const surface_name[SURFACES] = {
    "one plane", "two planes", "two meshes", "two profiles", "ten boxes", "T-junctions", "folds",
    "slivers", "doubled triangles", "periodic seam", "belts at rest", "fixed blocks"};
enum { lanes = 40 };

static int flat(int body) { return body >= DISC; }           /* in a planar world */
static int exists(int body, int surface) {
    return !flat(body) || surface <= PLANES || surface == PROFILES || surface == BLOCKS;
}
static dem_vec3 middle_of(int body, int lane) {
    return flat(body) ? at(pitch*lane, 0, 0) : at(0, 0, pitch*lane);
}

/* --- surfaces: all at y = 0 about the middle of each lane, in pieces that touch at x = 0 --- */

/* A mesh that grows. */
typedef struct sheet {
    dem_real v[3*16*20*lanes];
    int32_t t[3*12*20*lanes];
    int points, triangles;
} sheet;
static void sheet_empty(sheet *s) { s->points = s->triangles = 0; }
static int32_t sheet_point(sheet *s, double x, double y, double z) {
    dem_real *p = s->v + 3*s->points;
    p[0] = (dem_real)x;
    p[1] = (dem_real)y;
    p[2] = (dem_real)z;
    return s->points++;
}
static void sheet_triangle(sheet *s, int32_t a, int32_t b, int32_t c) {
    int32_t *t = s->t + 3*s->triangles++;
    t[0] = a;
    t[1] = b;
    t[2] = c;
}
/* A rectangle at y = 0 that faces up, or down. */
static void sheet_rectangle(sheet *s, double x0, double z0, double x1, double z1, int down) {
    const int32_t a = sheet_point(s, x0, 0, z0), b = sheet_point(s, x0, 0, z1);
    const int32_t c = sheet_point(s, x1, 0, z1), d = sheet_point(s, x1, 0, z0);
    sheet_triangle(s, a, down ? c : b, down ? b : c);
    sheet_triangle(s, a, down ? d : c, down ? c : d);
}
static void sheet_box(sheet *s, double x0, double x1, double y0, double z0, double z1) {
    static const int corner[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3},
                                     {0, 2, 3, 1}, {4, 5, 7, 6}};
    int32_t p[8];
    int i;
    for (i = 0; i < 8; i++) p[i] = sheet_point(s, i & 1 ? x1 : x0, i & 2 ? 0 : y0, i & 4 ? z1 : z0);
    for (i = 0; i < 6; i++) {
        sheet_triangle(s, p[corner[i][0]], p[corner[i][1]], p[corner[i][2]]);
        sheet_triangle(s, p[corner[i][0]], p[corner[i][2]], p[corner[i][3]]);
    }
}
static dem_wall sheet_add(dem_world *w, dem_material m, sheet *s) {
    dem_mesh mesh;
    dem_wall wall;
    mesh.vertex_count = s->points;
    mesh.triangle_count = s->triangles;
    mesh.vertices = s->v;
    mesh.triangles = s->t;
    wall = dem_wall_mesh_add(w, m, &mesh);
    CHECK(wall.id > 0);
    sheet_empty(s);
    return wall;
}
/* The pieces of one lane, about (0, 0, z), in one mesh. */
static void lane_pieces(sheet *s, int surface, double z, uint64_t *seed) {
    const double z0 = z - half, z1 = z + half;
    int i;
    if (surface == PERIODIC) sheet_rectangle(s, -half, z0, half, z1, 0);
    if (surface == JUNCTIONS) {                 /* two corners on the edge of a third rectangle */
        sheet_rectangle(s, -half, z0, 0, z1, 0);
        sheet_rectangle(s, 0, z0, half, z, 0);
        sheet_rectangle(s, 0, z, half, z1, 0);
    }
    if (surface == DOUBLED) {                   /* the right half: once more, and upside down */
        sheet_rectangle(s, -half, z0, 0, z1, 0);
        sheet_rectangle(s, 0, z0, half, z1, 0);
        sheet_rectangle(s, 0, z0, half, z1, 0);
        sheet_rectangle(s, 0, z0, half, z1, 1);
    }
    if (surface == SLIVERS) {                   /* 1e-5 R to 0.1 R wide, 12 R long */
        double x = -0.5*R;
        sheet_rectangle(s, -half, z0, x, z1, 0);
        for (i = 0; i < 18; i++) {
            const double next = x + R*pow(10, -1 - 4*pow(scene_random(seed), 3));
            sheet_rectangle(s, x, z0, next, z1, 0);
            x = next;
        }
        sheet_rectangle(s, x, z0, half, z1, 0);
    }
    if (surface == FOLDS) {                     /* beyond x = 0 two triangles of one edge overlap */
        const int32_t a = sheet_point(s, 0, 0, z0), b = sheet_point(s, 0, 0, z1);
        const int32_t c = sheet_point(s, half, 0, z);
        const int32_t d = sheet_point(s, half, 0, z0), e = sheet_point(s, half, 0, z1);
        const int32_t f = sheet_point(s, -half, 0, z0), g = sheet_point(s, -half, 0, z1);
        sheet_triangle(s, a, b, c);
        sheet_triangle(s, a, b, e);
        sheet_triangle(s, a, c, d);
        sheet_triangle(s, b, e, c);
        sheet_triangle(s, a, f, b);
        sheet_triangle(s, f, g, b);
    }
}
static void profiles_add(dem_world *w, dem_material m, int body) {
    dem_real v[4*lanes];
    int32_t s[2*lanes];
    dem_profile p;
    int i, k, count = flat(body) ? lanes : 1;
    p.vertex_count = 2*count;
    p.segment_count = count;
    p.vertices = v;
    p.segments = s;
    for (k = 0; k < 2; k++) {
        for (i = 0; i < count; i++) {
            const double x = (double)middle_of(body, i).x;
            v[4*i] = (dem_real)(k ? x : x - half);
            v[4*i + 2] = (dem_real)(k ? x + half : x);
            v[4*i + 1] = v[4*i + 3] = 0;
            s[2*i] = 2*i;
            s[2*i + 1] = 2*i + 1;
        }
        CHECK(dem_wall_profile_add(w, m, &p, DEM_EDGE_RESOLVED).id > 0);
    }
}
/* Four cubes that share an edge at x = z = 0, in the plane two squares, which never move. */
static void blocks_add(dem_world *w, dem_material m, int body) {
    const double a = half/2;
    const double corners[8] = {-a, -a, a, -a, a, a, -a, a};
    dem_real square[8];
    dem_shape block;
    int i, k;
    for (i = 0; i < 8; i++) square[i] = (dem_real)corners[i];
    block = flat(body) ? dem_shape_polygon_add(w, 4, square) : scene_box(w, half, half, half);
    for (i = 0; i < lanes; i++)
        for (k = 0; k < (flat(body) ? 2 : 4); k++) {
            const dem_vec3 off = at(k & 1 ? a : -a, -a, flat(body) ? 0 : k & 2 ? a : -a);
            const dem_vec3 x = demi_add(middle_of(body, i), off);
            const dem_body b = dem_body_add(w, m, block, x, dem_quat_make(1, 0, 0, 0));
            dem_body_state s = scene_state(w, b);
            s.fixed = 1;
            CHECK_EQ(dem_body_set(w, b, &s), DEM_OK);
        }
}
static void surface_add(dem_world *w, dem_material m, int body, int surface) {
    static sheet s;
    const double length = pitch*lanes;
    uint64_t seed = 11;
    int i, k;
    sheet_empty(&s);
    if (surface <= PLANES) dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 1, 0));
    if (surface == PLANES) dem_wall_plane_add(w, m, at(0.1, 0, 0.03), at(0, 1, 0));
    if (surface == PROFILES) profiles_add(w, m, body);
    if (surface == BLOCKS) blocks_add(w, m, body);
    if (surface == BOXES)                       /* ten walls; a box of each in every lane */
        for (k = 0; k < 10; k++) {
            const double wide = half/6, x = wide*(k - 5);
            for (i = 0; i < lanes; i++)
                sheet_box(&s, x, x + wide, -3*R, pitch*i - half, pitch*i + half);
            sheet_add(w, m, &s);
        }
    if (surface == MESHES || surface == BELTS)
        for (k = 0; k < 2; k++) {
            dem_motion motion = DEM_MOTION;
            dem_wall wall;
            sheet_rectangle(&s, k ? 0 : -half, -length, k ? half : 0, 2*length, 0);
            wall = sheet_add(w, m, &s);
            motion.kind = DEM_MOTION_TRANSLATING;
            /* one of the belts has a motion of speed 0, so dem.h does not join them */
            if (surface == BELTS && k) CHECK_EQ(dem_wall_motion_set(w, wall, &motion), DEM_OK);
        }
    for (i = 0; i < lanes; i++) lane_pieces(&s, surface, pitch*i, &seed);
    if (s.triangles) sheet_add(w, m, &s);
}

/* --- bodies --- */
static dem_shape shape_add(dem_world *w, int body) {
    static const double balls[9] = {-0.35, 0, 0, 0.45, 0.1, 0, 0, -0.3, 0.4};
    static const double sizes[3] = {0.7, 0.6, 0.5};
    static const double outline[10] = {-0.9, -0.5, 0.3, -0.8, 1, -0.1, 0.4, 0.8, -0.7, 0.6};
    dem_cluster_desc c = DEM_CLUSTER_DESC;
    dem_real p[10], radii[3];
    dem_shape two[2];
    uint64_t seed = 5;
    int i;
    for (i = 0; i < 10; i++) p[i] = (dem_real)(R*outline[i]);
    if (body == POLYGON) return dem_shape_polygon_add(w, 5, p);
    if (body == ELLIPSOID) return dem_shape_ellipsoid_add(w, at(1.2*R, 0.7*R, 0.9*R));
    if (body == CUBE) return scene_box(w, 1.5*R, 1.5*R, 1.5*R);
    if (body == ROCK) return scene_rock(w, &seed, 18, 1.1*R);
    if (body == UNION) {                        /* an L */
        for (i = 0; i < 6; i++) p[i] = 0;
        p[3] = (dem_real)(0.6*R);
        p[4] = (dem_real)(0.5*R);
        two[0] = scene_box(w, 0.8*R, 1.8*R, R);
        two[1] = scene_box(w, 0.8*R, 0.8*R, R);
        return dem_shape_union_add(w, 2, two, p, 0);
    }
    for (i = 0; i < 9; i++) p[i] = (dem_real)(R*balls[i]);
    for (i = 0; i < 3; i++) radii[i] = (dem_real)(R*sizes[i]);
    c.count = 3;
    c.positions = p;
    c.radii = radii;
    c.rays = 64;
    return dem_shape_cluster_add(w, &c);
}
typedef struct lane {
    dem_body body;
    dem_vec3 middle, velocity;       /* m; m/s, of the throw */
    double energy;                   /* J, of the throw */
    uint64_t seed;
} lane;

static int index_of(const dem_world *w, const lane *l) {
    return w->bodies.slot_index[l->body.slot - 1];
}
/* J, of motion. */
static double energy_of(const dem_world *w, const lane *l) {
    const int i = index_of(w, l);
    const dem_vec3 v = demi_at(w->bodies.vel + 4*i), spin = demi_at(w->bodies.spin + 4*i);
    const double turning = (double)demi_dot(spin, demi_angular_of(w, i))/2;
    return (double)w->bodies.mass[i]*(double)demi_dot(v, v)/2 + turning;
}
static dem_vec3 any_direction(uint64_t *seed) {
    const double y = 2*scene_random(seed) - 1, a = 2*pi*scene_random(seed), s = sqrt(1 - y*y);
    return at(s*cos(a), y, s*sin(a));
}

/* --- cells of the table --- */
typedef struct cell {
    int body, surface, impulses;
    int upwards;                     /* 1: free flight, without an impact */
    double dt, bound;                /* s; gain allowed, over the energy before */
    long impacts, gaining;           /* gaining: those that gain more than the bound */
    long through;                    /* bodies that fell through the surface */
    double gain;                     /* largest, over the energy before */
} cell;
/* Throws the body of a lane down at the joint at 0.5 to 1 m/s, up to 70 degrees from the vertical,
   with a spin of up to 400 rad/s; upwards with up to 1400 rad/s, as between several impacts. It
   starts so low that the impact follows soon, but with impulses not in the first step. Half of the
   throws point at the joint, within 0.05 R, the others within R. */
static void lane_throws(dem_world *w, const cell *c, lane *l, uint64_t number) {
    uint64_t seed = l->seed = number;
    const double speed = 0.5 + 0.5*scene_random(&seed), lean = 1.22*scene_random(&seed);
    const double about = 2*pi*scene_random(&seed), down = speed*cos(lean), side = speed*sin(lean);
    const double aside = scene_random(&seed) < 0.5 ? 0.05*R : R;
    const double spin = (c->upwards ? 1400 : 400)*scene_random(&seed);
    const double gap = R*((c->upwards ? 1 : c->impulses ? 0.15 : 0.01) + 0.1*scene_random(&seed));
    const double aim = scene_random(&seed);
    const dem_vec3 axis = any_direction(&seed);
    const dem_vec3 x = scene_at(&seed, 2*aside, -aside, 0, 0, 2*aside, -aside);
    dem_body_state s = scene_state(w, l->body);
    if (flat(c->body)) s.orientation = dem_quat_about(at(0, 0, 1), (dem_real)(2*pi*aim));
    else s.orientation = scene_turn(&seed);
    s.position = demi_add(l->middle, at((double)x.x, 0, flat(c->body) ? 0 : (double)x.z));
    s.velocity = at(side*cos(about), c->upwards ? down : -down,
                    flat(c->body) ? 0 : side*sin(about));
    s.spin = flat(c->body) ? at(0, 0, about < pi ? spin : -spin) : demi_scale(axis, (dem_real)spin);
    CHECK_EQ(dem_body_set(w, l->body, &s), DEM_OK);
    s.position.y = (dem_real)gap + demi_support(w, index_of(w, l), at(0, -1, 0));
    CHECK_EQ(dem_body_set(w, l->body, &s), DEM_OK);
    l->energy = energy_of(w, l);
    l->velocity = demi_at(w->bodies.vel + 4*index_of(w, l));
}
static dem_world *cell_world(const cell *c, lane *l) {
    dem_world_desc d = DEM_WORLD_DESC;
    dem_shape shape = {0};
    dem_material m;
    dem_world *w;
    int i;
    d.threads = 1;
    d.planar = flat(c->body);
    d.dt = (dem_real)c->dt;
    d.allow_large_dt = 1;
    if (c->impulses) {
        d.response = DEM_RESPONSE_IMPULSES;
        d.tolerance = DEM_R(1e-7);
        d.sweeps = 5000;             /* with 200, unsolved steps gain up to 1e-3 on blocks */
    }
    if (c->surface == PERIODIC) {
        d.boundary[0] = DEM_BOUNDARY_PERIODIC;
        d.domain = box_of(-half, -50*R, -50*R, half, 50*R, pitch*lanes + 50*R);
    }
    w = dem_world_create(&d);
    m = scene_material(w, c->impulses ? 0 : flat(c->body) ? 1e9 : 1e7, 1, 0, 0);
    surface_add(w, m, c->body, c->surface);
    if (c->body != BALL && c->body != DISC) shape = shape_add(w, c->body);
    for (i = 0; i < lanes; i++) {
        dem_vec3 x;
        l[i].middle = middle_of(c->body, i);
        if (c->surface == PERIODIC) l[i].middle.x = (dem_real)half;
        x = demi_add(l[i].middle, at(0, 3*R, 0));
        l[i].body = shape.id ? dem_body_add(w, m, shape, x, dem_quat_make(1, 0, 0, 0))
            : dem_sphere_add(w, m, (dem_real)R, x);
    }
    CHECK_STR(dem_world_error_get(w), "");
    return w;
}
/* Counts the impact of a lane if its body has left. Returns 0 if it is still on its way. */
static int lane_ends(const dem_world *w, cell *c, const lane *l) {
    const int i = index_of(w, l);
    const dem_vec3 x = demi_at(w->bodies.pos + 4*i), v = demi_at(w->bodies.vel + 4*i);
    const dem_vec3 off = demi_sub(x, l->middle);
    const double reach = 1.6*R, across = c->surface == PERIODIC ? 0 : fabs((double)off.x);
    const int clear = (double)x.y > (c->upwards ? 3*R : reach) && (double)v.y > 0;
    const int strays = fmax(across, fabs((double)off.z)) > half - reach;
    const int hit = (double)demi_length(demi_sub(v, l->velocity)) > 1e-9;
    const double gain = energy_of(w, l)/l->energy - 1;
    if ((double)x.y < -R || !(gain < 1e9)) { c->through++; return 1; }
    if (!clear && !strays) return 0;
    if (!hit && !c->upwards) return 1;
    c->impacts++;
    c->gain = fmax(c->gain, gain);
    if (gain > c->bound && c->gaining++ < 3)
        printf("    a %s on %s by %s, dt %.3g s, throw %lu: gains %.3g, bound %.3g, spin %.0f\n",
               body_name[c->body], surface_name[c->surface], c->impulses ? "impulses" : "springs",
               c->dt, (unsigned long)l->seed, gain, c->bound,
               (double)demi_length(demi_at(w->bodies.spin + 4*i)));
    return 1;
}
static void cell_run(cell *c, long wanted) {
    static lane l[lanes];
    const int batch = c->impulses ? 1 : 16;
    dem_world *w = cell_world(c, l);
    uint64_t number = 1;
    long steps = 0;
    int i;
    for (i = 0; i < lanes; i++) lane_throws(w, c, &l[i], number++);
    while (c->impacts < wanted) {
        if (scene_step(w, batch) != DEM_OK || (steps += batch) > 3000*(wanted/lanes + 1)) {
            CHECK(0 && "all bodies leave");
            break;
        }
        for (i = 0; i < lanes; i++)
            if (lane_ends(w, c, &l[i])) lane_throws(w, c, &l[i], number++);
    }
    CHECK(c->impacts >= wanted);
    CHECK_EQ(c->through, 0);
    dem_world_destroy(w);
}
/* s. By springs about a fiftieth of the duration of a contact. */
static double step_of(int body, int impulses) {
    static const double steps[BODIES] = {8.2e-6, 5.2e-6, 5.3e-6, 1.2e-5, 1.2e-5, 1.2e-5, 1.4e-5,
                                         7e-6};
    return impulses ? 1e-4 : steps[body];
}
static cell cell_of(int body, int surface, int impulses) {
    cell c;
    memset(&c, 0, sizeof c);
    c.body = body;
    c.surface = surface;
    c.impulses = impulses;
    c.dt = step_of(body, impulses);
    c.bound = 1;
    return c;
}
static long impacts_of(int body, int impulses) {
    const int slow = !impulses && ((body >= CUBE && body <= UNION) || body == POLYGON);
    return at_length() ? (slow ? 3000 : 8500) : 60;
}
/* The error of the step of a body: the largest gain on one plane, or in free flight. */
static double error_of(int body, int impulses) {
    cell c = cell_of(body, PLANE, impulses);
    c.upwards = impulses;
    cell_run(&c, impacts_of(body, impulses)*(at_length() ? 1 : 5));
    return c.gain;
}
/* How many bodies act individually on a body at the joint, because dem.h does not join bodies. */
static int pieces_of(int body, int surface) {
    return surface != BLOCKS ? 1 : flat(body) ? 2 : 4;
}

typedef struct sums { long impacts, gaining; double gain; } sums;
/* All bodies on all surfaces: the largest gain of each cell, over the bound of that cell. */
static sums table_of(int impulses) {
    sums all = {0, 0, 0};
    double error[BODIES], seconds = (double)clock()/CLOCKS_PER_SEC;
    int body, surface;
    if (tables()) {
        printf("    %-18s", impulses ? "impulses" : "springs");
        for (body = 0; body < BODIES; body++) printf(" %9s", body_name[body]);
        printf("   impacts\n    %-18s", "error of the step");
    }
    for (body = 0; body < BODIES; body++) {
        error[body] = error_of(body, impulses);
        CHECK_NEAR(error[body], 0, impulses ? 1e-5 : 4e-4);     /* of order dt^2 to dt^2.5 */
        if (tables()) printf(" %9.1e", error[body]);
    }
    if (tables()) printf("\n");
    for (surface = impulses ? PLANE : PLANES; surface < SURFACES; surface++) {
        long impacts = 0;
        if (tables()) printf("    %-18s", surface_name[surface]);
        for (body = 0; body < BODIES; body++) {
            cell c = cell_of(body, surface, impulses);
            if (!exists(body, surface)) { if (tables()) printf(" %9s", ""); continue; }
            /* by springs each piece has a contact, which begins and ends with its own error */
            c.bound = (impulses ? 2 : fmax(2, 1.5*pieces_of(body, surface)))*error[body];
            c.bound += impulses ? 1e-7 : 1e-6;
            cell_run(&c, impacts_of(body, impulses));
            if (tables()) printf(" %9.1e", c.gain);
            impacts += c.impacts;
            all.gaining += c.gaining;
            all.gain = fmax(all.gain, c.gain);
            fflush(stdout);
        }
        if (tables()) printf(" %9ld\n", impacts);
        all.impacts += impacts;
    }
    seconds = (double)clock()/CLOCKS_PER_SEC - seconds;
    if (tables())
        printf("    %ld impacts, %ld of them gain, in %.0f s\n", all.impacts, all.gaining, seconds);
    printf("impacts = %ld\nimpacts_gaining = %ld\n", all.impacts, all.gaining);
    return all;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("by springs elastic impacts on joined surfaces gain no more than the error of the step") {
        const sums all = table_of(0);
        CHECK(all.impacts >= (at_length() ? 400000 : 4000));
        CHECK_EQ(all.gaining, 0);
    }
    TEST("by impulses elastic impacts on joined surfaces gain no more than the error of the step") {
        const sums all = table_of(1);
        CHECK(all.impacts >= (at_length() ? 600000 : 4000));
        CHECK_EQ(all.gaining, 0);
    }
    TEST("by springs the largest gain on fixed blocks falls by more than 3 with half the step") {
        int body;
        for (body = 0; body < BODIES; body++) {
            cell one = cell_of(body, BLOCKS, 0), two = one;
            if (body != BALL && body != DISC && !(body == ELLIPSOID && at_length())) continue;
            two.dt /= 2;
            cell_run(&one, at_length() ? 9000 : 800);
            cell_run(&two, at_length() ? 9000 : 800);
            CHECK(one.gain > 0);
            CHECK_NEAR(two.gain, 0, one.gain/3);
        }
    }
    return test_end();
}
