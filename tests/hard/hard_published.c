/* Hard cases: the edge of stability, floors of triangles, memory that turns with its contact, wide
   size ratios, long runs without dissipation. Each test names where its case or its number comes
   from. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

static dem_vec3 at(double x, double y, double z) {
    return dem_vec3_make((dem_real)x, (dem_real)y, (dem_real)z);
}
static double dot(dem_vec3 a, dem_vec3 b) { return (double)(a.x*b.x + a.y*b.y + a.z*b.z); }
static double length(dem_vec3 a) { return sqrt(dot(a, a)); }
static dem_vec3 cross(dem_vec3 a, dem_vec3 b) {
    return dem_vec3_make(a.y*b.z - a.z*b.y, a.z*b.x - a.x*b.z, a.x*b.y - a.y*b.x);
}
static dem_vec3 mix(dem_vec3 a, double s, dem_vec3 b) { /* a + s b */
    return at((double)a.x + s*(double)b.x, (double)a.y + s*(double)b.y,
              (double)a.z + s*(double)b.z);
}
static dem_body_state state_of(const dem_world *world, dem_body body) {
    dem_body_state s;
    memset(&s, 0, sizeof s);
    dem_body_get(world, body, &s);
    return s;
}
static void set_motion(dem_world *world, dem_body body, dem_vec3 velocity, dem_vec3 spin) {
    dem_body_state s = state_of(world, body);
    s.velocity = velocity;
    s.spin = spin;
    dem_body_set(world, body, &s);
}
static void step(dem_world *world, int steps) {
    if (dem_world_step(world, steps) != DEM_OK) puts(dem_world_error_get(world));
}
static dem_world_desc one_thread(double dt) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.threads = 1;
    desc.dt = (dem_real)dt;
    desc.allow_large_dt = 1;
    return desc;
}
static dem_material_desc linear_stuff(double density, double stiffness, double restitution,
                                      double friction) {
    dem_material_desc m = DEM_MATERIAL_DESC;
    m.density = (dem_real)density;
    m.young = DEM_R(1e7);
    m.poisson = DEM_R(0.25);
    m.restitution = (dem_real)restitution;
    m.friction = (dem_real)friction;
    m.stiffness = (dem_real)stiffness;
    m.stiffness_ratio = 1;
    return m;
}
static dem_material_desc hertz_stuff(double density, double young, double poisson,
                                     double restitution, double friction) {
    dem_material_desc m = DEM_MATERIAL_DESC;
    m.density = (dem_real)density;
    m.young = (dem_real)young;
    m.poisson = (dem_real)poisson;
    m.restitution = (dem_real)restitution;
    m.friction = (dem_real)friction;
    return m;
}
static dem_wall mesh_add(dem_world *world, dem_material material, const dem_real *vertices,
                         int vertex_count, const int32_t *triangles, int triangle_count) {
    dem_mesh mesh;
    mesh.vertex_count = vertex_count;
    mesh.triangle_count = triangle_count;
    mesh.vertices = (dem_real *)(uintptr_t)vertices;    /* the data is copied, never written */
    mesh.triangles = (int32_t *)(uintptr_t)triangles;
    return dem_wall_mesh_add(world, material, &mesh);
}
/* A floor y = 0 from (x0, z0) to (x1, z1) in nx by nz quads of two triangles. */
static dem_wall grid_floor(dem_world *world, dem_material material, double x0, double z0,
                           double x1, double z1, int nx, int nz) {
    static dem_real v[3*2048];
    static int32_t t[6*2048];
    int i, k, n = 0;
    for (k = 0; k <= nz; k++)
        for (i = 0; i <= nx; i++) {
            dem_real *p = v + 3*(i + k*(nx + 1));
            p[0] = (dem_real)(x0 + (x1 - x0)*i/nx);
            p[1] = 0;
            p[2] = (dem_real)(z0 + (z1 - z0)*k/nz);
        }
    for (k = 0; k < nz; k++)
        for (i = 0; i < nx; i++) {
            const int32_t a = (int32_t)(i + k*(nx + 1)), b = a + 1;
            const int32_t c = a + (int32_t)nx + 1, d = c + 1;
            const int32_t quad[6] = {a, c, b, b, c, d};
            memcpy(t + n, quad, sizeof quad);
            n += 6;
        }
    return mesh_add(world, material, v, (nx + 1)*(nz + 1), t, n/3);
}

/* ---- 5.1, 5.2: the edge of stability ---- */

/* R = 1 m, m = 1 kg, k = 1 N/m, pressed together by 1e-6 N: dt is in units of sqrt(m/k) */
typedef enum mode { WALL_NORMAL, WALL_TANGENT, PAIR_NORMAL, PAIR_TANGENT } mode;
static dem_vec3 squeeze(dem_vec3 x, dem_vec3 v, dem_real r, dem_real m, double t, void *user) {
    (void)v; (void)r; (void)m; (void)t;
    return at(x.x > 0 ? -*(double *)user : *(double *)user, 0, 0);
}
/* How much a disturbance has grown: the largest of the last `look` steps over the first. */
static double growth(mode what, dem_integrator integrator, double dt, int steps, int look) {
    const double press = 1e-6, nudge = 1e-13;
    const int pair = what == PAIR_NORMAL || what == PAIR_TANGENT;
    const dem_vec3 way = what == WALL_NORMAL || what == PAIR_NORMAL ? at(1, 0, 0) : at(0, 1, 0);
    double most = 0, p = press;
    dem_material_desc stuff = linear_stuff(3/(4*pi), 1, 1, pair || what == WALL_TANGENT ? 1 : 0);
    dem_world_desc desc = one_thread(dt);
    dem_world *world;
    dem_material m;
    dem_body a, b;
    int i;
    desc.normal_law = DEM_NORMAL_LINEAR;
    desc.tangent_law = DEM_TANGENT_SPRING;
    desc.integrator = integrator;
    if (pair) { desc.force = squeeze; desc.force_user = &p; }
    else desc.gravity.x = (dem_real)-press;
    if (what == WALL_NORMAL || what == PAIR_NORMAL) desc.tangent_law = DEM_TANGENT_NONE;
    world = dem_world_create(&desc);
    m = dem_material_add(world, &stuff);
    if (pair) {
        a = dem_sphere_add(world, m, 1, at(1 - press/2, 0, 0));
        b = dem_sphere_add(world, m, 1, at(-1 + press/2, 0, 0));
        set_motion(world, b, mix(at(0, 0, 0), -nudge, way), at(0, 0, 0));
    } else {
        dem_wall_plane_add(world, m, at(0, 0, 0), at(1, 0, 0));
        a = b = dem_sphere_add(world, m, 1, at(1 - press, 0, 0));
    }
    set_motion(world, a, mix(at(0, 0, 0), nudge, way), at(0, 0, 0));
    for (i = 0; i < steps; i++) {
        dem_body_state s, t;
        double size;
        step(world, 1);
        s = state_of(world, a);
        t = state_of(world, b);
        /* slip of the surfaces at the contact, or speed of approach */
        if (what == WALL_NORMAL) size = fabs((double)s.velocity.x);
        else if (what == PAIR_NORMAL) size = fabs((double)(s.velocity.x - t.velocity.x))/2;
        else if (what == WALL_TANGENT) size = fabs((double)(s.velocity.y - s.spin.z));
        else size = fabs((double)(s.velocity.y - t.velocity.y - s.spin.z - t.spin.z))/2;
        if (i >= steps - look && size > most) most = size;
    }
    dem_world_destroy(world);
    return most/nudge;
}
/* Below the limit a disturbance stays within a few times its size for ever; above, it grows by more
   than a quarter a step. */
static void check_limit(mode what, dem_integrator integrator, double limit, double margin) {
    CHECK(growth(what, integrator, limit*(1 - margin), 20000, 20000) < 50);
    CHECK(growth(what, integrator, limit*(1 + margin), 50, 5) > 1000);
}

/* ---- 5.9: memory that turns ---- */

typedef struct turning { double pull; dem_vec3 axis; } turning;   /* pull: 1/s2 towards the axis */
static dem_vec3 towards_axis(dem_vec3 x, dem_vec3 v, dem_real r, dem_real m, double t, void *user) {
    const turning *c = (const turning *)user;
    const dem_vec3 off = mix(x, -dot(x, c->axis), c->axis);
    (void)v; (void)r; (void)t;
    return at(-(double)m*c->pull*(double)off.x, -(double)m*c->pull*(double)off.y,
              -(double)m*c->pull*(double)off.z);
}
/* A spring frozen at its first value: the tangential force is the memory, turned, nothing else. */
static void frozen_spring(const dem_contact *c, dem_real *memory, dem_contact_force *push) {
    const dem_vec3 first = *(const dem_vec3 *)c->user;
    dem_vec3 s = dem_vec3_make(memory[0], memory[1], memory[2]);
    s = memory[3] > 0 ? dem_memory_rotate(c, s) : first;
    memory[0] = s.x; memory[1] = s.y; memory[2] = s.z; memory[3] = 1;
    push->tangent = s;
}
typedef struct turned { double size, tilt, direction, work, torque; } turned; /* worst deviations */

/* Two touching spheres (R = 1, overlap .05, 1e20 kg, so that forces of order one do not move them)
   turn as one rigid body about an axis through the point they touch at, once round in `steps`
   steps. A pull towards the axis keeps velocity Verlet on the circle exactly. */
static turned turn_once(dem_vec3 axis, int own_law, int steps) {
    const double angle = 2*pi/steps, dt = 1.0/steps, distance = 1.95;
    const double rate = sin(angle)/dt;       /* makes v(t) of velocity Verlet the rigid body's */
    dem_world_desc desc = one_thread(dt);
    dem_material_desc stuff = linear_stuff(3e20/(4*pi), 1, 1, 1e6);
    dem_world *world;
    dem_material m;
    dem_body body[2];
    dem_vec3 n = at(1, 0, 0), side, first = at(0, 0, 1), f0;
    dem_contact_info c;
    turning centre;
    turned worst = {0, 0, 0, 0, 0};
    double size0;
    int i, k;
    axis = mix(at(0, 0, 0), 1/length(axis), axis);
    side = cross(axis, n);
    centre.pull = 0;
    centre.axis = axis;
    desc.normal_law = DEM_NORMAL_LINEAR;
    desc.tangent_law = DEM_TANGENT_SPRING;
    desc.force = towards_axis;
    desc.force_user = &centre;
    if (own_law) {
        first = at(0, 3, 4);                 /* N */
        desc.law = frozen_spring;
        desc.law_user = &first;
        desc.law_memory = 4;
        desc.law_vectors = 1;
        desc.law_stiffness = 1;
    }
    world = dem_world_create(&desc);
    m = dem_material_add(world, &stuff);
    for (i = 0; i < 2; i++)
        body[i] = dem_sphere_add(world, m, 1, mix(at(0, 0, 0), i ? distance/2 : -distance/2, n));
    if (own_law) step(world, 1);             /* the law writes its memory */
    else { /* spins in place load the spring to 100 m, 3:4 in y and z */
        const dem_vec3 spin = at(0, 80/distance, -60/distance);
        for (i = 0; i < 2; i++) set_motion(world, body[i], at(0, 0, 0), spin);
        step(world, steps);
    }
    centre.pull = pow(2*sin(angle/2)/dt, 2);
    for (i = 0; i < 2; i++)
        set_motion(world, body[i], mix(at(0, 0, 0), (i ? 1 : -1)*rate*distance/2, side),
                   mix(at(0, 0, 0), rate, axis));            /* no slip over a step */
    CHECK_EQ(dem_candidates_rebuild(world), DEM_OK); /* setting a body's state drops the list */
    CHECK_EQ(dem_contacts_get(world, &c, 1), 1);
    f0 = mix(c.force, -dot(c.force, c.normal), c.normal);
    size0 = length(f0);
    CHECK_REL(size0, own_law ? 5 : 100, 1e-4);
    for (i = 1; i <= steps; i++) {
        const double turned_by = angle*i;
        dem_vec3 ft, should, along;
        dem_body_state s[2];
        double power = 0, push;
        step(world, 1);
        if (i % (steps/40)) continue;
        if (dem_contacts_get(world, &c, 1) != 1) { CHECK(0 && "in touch"); break; }
        ft = mix(c.force, -dot(c.force, c.normal), c.normal);
        /* f0 turned about the axis (Rodrigues), for a or b as first partner alike */
        along = mix(at(0, 0, 0), dot(axis, f0), axis);
        should = mix(mix(along, cos(turned_by), mix(f0, -1, along)), sin(turned_by),
                     cross(axis, f0));
        for (k = 0; k < 2; k++) {
            s[k] = state_of(world, body[k]);
            power += dot(s[k].torque, axis);
        }
        /* force of the contact on a: total minus the pull; both bodies move rigidly about the axis,
           so power is the moment about it */
        power += dot(cross(mix(s[0].position, -1, s[1].position), ft), axis)*
                 (dot(mix(s[0].position, -1, s[1].position), c.normal) < 0 ? 1 : -1);
        worst.size = fmax(worst.size, fabs(length(ft)/size0 - 1));
        push = own_law ? 0 : (double)c.overlap;              /* k = 1                             */
        worst.tilt = fmax(worst.tilt, fabs(dot(c.force, c.normal) + push)/size0);
        worst.direction = fmax(worst.direction, length(mix(ft, -1, should))/size0);
        worst.work = fmax(worst.work, fabs(power)/size0);
        worst.torque = fmax(worst.torque, fabs(length(s[0].torque)/(size0*distance/2) - 1));
    }
    dem_world_destroy(world);
    return worst;
}

static void check_turned(turned t, int twisted) {
    CHECK_NEAR(t.size, 0, 1e-10);
    CHECK_NEAR(t.tilt, 0, 1e-10);
    CHECK_NEAR(t.torque, 0, 1e-10);
    CHECK_NEAR(t.work, 0, 1e-10);
    CHECK_NEAR(t.direction, 0, twisted ? 1e-7 : 1e-9);
}

/* ---- 5.12: pairs ---- */

static double uniform(uint64_t *state) {
    *state = *state*UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*state >> 11)/9007199254740992.0;
}
static int pair_order(const void *a, const void *b) {
    const uint32_t *x = (const uint32_t *)a, *y = (const uint32_t *)b;
    if (x[0] != y[0]) return x[0] < y[0] ? -1 : 1;
    return x[1] < y[1] ? -1 : x[1] > y[1];
}
static void pairs_sort(uint32_t *pairs, int count) {
    int i;
    for (i = 0; i < count; i++)
        if (pairs[2*i] > pairs[2*i + 1]) {
            const uint32_t t = pairs[2*i];
            pairs[2*i] = pairs[2*i + 1];
            pairs[2*i + 1] = t;
        }
    qsort(pairs, (size_t)count, 2*sizeof *pairs, pair_order);
}
/* Pairs nearer than radii plus skin, straight from the positions. Answers how many; sorted. */
static int pairs_by_force(const dem_world *world, double skin, uint32_t *out) {
    const dem_bodies b = dem_bodies_get(world);
    int i, j, n = 0;
    for (i = 0; i < b.count; i++)
        for (j = i + 1; j < b.count; j++) {
            const dem_real *p = b.positions + 4*i, *q = b.positions + 4*j;
            const double dx = (double)(p[0] - q[0]), dy = (double)(p[1] - q[1]);
            const double dz = (double)(p[2] - q[2]), cut = (double)(p[3] + q[3]) + skin;
            if (!(dx*dx + dy*dy + dz*dz < cut*cut)) continue;
            out[2*n] = dem_body_id_get(world, i).slot;
            out[2*n + 1] = dem_body_id_get(world, j).slot;
            n++;
        }
    pairs_sort(out, n);
    return n;
}

/* 1: no small body's centre within `near_by` of the place. */
static int far_from_all(const dem_world *world, double x, double y, double z, double near_by) {
    const dem_bodies b = dem_bodies_get(world);
    int i;
    for (i = 0; i < b.count; i++)
        if (b.positions[4*i + 3] < 1 && length(mix(at(x, y, z), -1, at((double)b.positions[4*i],
            (double)b.positions[4*i + 1], (double)b.positions[4*i + 2]))) < near_by) return 0;
    return 1;
}

/* ---- 5.16: drops on facet, edge, vertex, grid ---- */

typedef enum target { FACET, EDGE, VERTEX, GRID, PLANE } target;
static dem_wall target_add(dem_world *world, dem_material m, target t) {
    static const dem_real facet[] = {-2, 0, -1, 2, 0, -1, 0, 0, DEM_R(2.3)};
    static const int32_t facet_corners[] = {0, 2, 1};
    static const dem_real fan[] = {0, 0, 0, 2, 0, DEM_R(0.3), 1, 0, 2, DEM_R(-1.2), 0, DEM_R(1.7),
                                   -2, 0, DEM_R(-0.4),
                                   DEM_R(-0.7), 0, -2, DEM_R(1.4), 0, DEM_R(-1.9)};
    static const int32_t fan_corners[] = {0, 2, 1, 0, 3, 2, 0, 4, 3, 0, 5, 4, 0, 6, 5, 0, 1, 6};
    static const dem_real edge[] = {-2, 0, 0, 2, 0, 0, DEM_R(0.3), 0, 2, DEM_R(-0.6), 0, -2};
    static const int32_t edge_corners[] = {0, 2, 1, 0, 1, 3};
    dem_wall none = {0};
    switch (t) {
    case FACET: return mesh_add(world, m, facet, 3, facet_corners, 1);
    case EDGE: return mesh_add(world, m, edge, 4, edge_corners, 2);
    case VERTEX: return mesh_add(world, m, fan, 7, fan_corners, 6);
    case GRID: return grid_floor(world, m, -2, -2, 2, 2, 20, 20); /* a vertex below the centre */
    case PLANE: return dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 1, 0));
    default: return none;
    }
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    /* A harmonic oscillator of frequency w is stable in the leapfrog family for w dt < 2, whatever
       k and m. */
    TEST("stability limit: a sphere on a linear wall stays bounded below dt = 2 sqrt(m/k) and "
         "diverges above") {
        check_limit(WALL_NORMAL, DEM_INTEGRATOR_SYMPLECTIC_EULER, 2, 0.02);
        check_limit(WALL_NORMAL, DEM_INTEGRATOR_LEAPFROG, 2, 0.02);
        check_limit(WALL_NORMAL, DEM_INTEGRATOR_VELOCITY_VERLET, 2, 0.02);
        check_limit(WALL_NORMAL, DEM_INTEGRATOR_POSITION_VERLET, 2, 0.02);
    }
    TEST("stability limit: 1.41421 sqrt(m/k) for two equal spheres in contact") {
        check_limit(PAIR_NORMAL, DEM_INTEGRATOR_SYMPLECTIC_EULER, sqrt(2.0), 0.01);
        check_limit(PAIR_NORMAL, DEM_INTEGRATOR_VELOCITY_VERLET, sqrt(2.0), 0.01);
    }
    TEST("stability limit: 1.06904 sqrt(m/kt) for the tangential spring of a sphere on a wall, "
         "spin included") {
        check_limit(WALL_TANGENT, DEM_INTEGRATOR_SYMPLECTIC_EULER, 2*sqrt(2.0/7), 0.01);
        check_limit(WALL_TANGENT, DEM_INTEGRATOR_LEAPFROG, 2*sqrt(2.0/7), 0.01);
        check_limit(WALL_TANGENT, DEM_INTEGRATOR_VELOCITY_VERLET, 2*sqrt(2.0/7), 0.01);
    }
    TEST("stability limit: 0.755929 sqrt(m/kt) for the tangential spring between two equal "
         "spheres") {
        check_limit(PAIR_TANGENT, DEM_INTEGRATOR_SYMPLECTIC_EULER, 2*sqrt(1.0/7), 0.01);
        check_limit(PAIR_TANGENT, DEM_INTEGRATOR_LEAPFROG, 2*sqrt(1.0/7), 0.01);
        check_limit(PAIR_TANGENT, DEM_INTEGRATOR_VELOCITY_VERLET, 2*sqrt(1.0/7), 0.01);
    }

    TEST("Rayleigh's time step: pi R sqrt(rho/G)/(0.1631 nu + 0.8766), 12.928 us for Chung & "
         "Ooi's glass") {
        static const double nu[] = {0.2, 0.3}, coefficient[] = {3.4553, 3.3944};
        int i;
        for (i = 0; i < 2; i++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_material_desc stuff = hertz_stuff(2800, 48e9, nu[i], 1, 0);
            const double shear = 48e9/(2*(1 + nu[i]));
            dem_world *world;
            dem_advice advice;
            desc.impact_speed = 20;
            world = dem_world_create(&desc);
            dem_sphere_add(world, dem_material_add(world, &stuff), DEM_R(0.01), at(0, 0, 0));
            CHECK_EQ(dem_step_advice_get(world, &advice), DEM_OK);
            /* the formula */
            CHECK_REL(advice.rayleigh, pi*0.01*sqrt(2800/shear)/(0.1631*nu[i] + 0.8766), 1e-6);
            /* as printed */
            CHECK_NEAR((double)advice.rayleigh/(0.01*sqrt(2800/shear)), coefficient[i], 5e-5);
            if (i == 0) {
                CHECK_NEAR((double)advice.rayleigh*1e6, 12.928, 5e-4);
                CHECK_REL(advice.contact_time, 40.33946e-6, 1e-4);
                CHECK_REL(advice.dt_max, 40.33946e-6/20, 1e-4);
            }
            dem_world_destroy(world);
        }
    }

    /* Vertex 3 lies within an edge of the second triangle: the mesh is flat, but not conforming. */
    TEST("MercuryDPM rolling over triangles: height, force and speed stay constant over edges and "
         "vertices") {
        static const dem_real vertices[] = {0, -1, 0, 0, 1, 0, 1, -1, 0, 1, 0, 0, 1, 1, 0, 2, -1, 0,
                                            2, 0, 0, 2, 1, 0};
        static const int32_t triangles[] = {0, 1, 4, 0, 2, 4, 2, 3, 6, 2, 5, 6, 3, 4, 7, 3, 6, 7};
        static const double start[][4] = {{2, -0.5, -1, 0}, {2, 0, -1, 0}, {1, -1, 0, 1},
                                          {2, -1, -0.6, 0.6}, {2, 1, -1, -1},
                                          {1.9, -0.93, -0.8, 0.55}};      /* x y, vx vy    */
        const dem_material_desc stuff = linear_stuff(6/pi, 2000, 1, 0);
        size_t i;
        int k;
        for (i = 0; i < sizeof start/sizeof *start; i++) {
            dem_world_desc desc = one_thread(1e-3);
            dem_world *world;
            dem_material m;
            dem_body body;
            const double *s = start[i];
            double dz = 0, dv = 0, df = 0;
            desc.gravity.z = -1;
            desc.normal_law = DEM_NORMAL_LINEAR;
            world = dem_world_create(&desc);
            m = dem_material_add(world, &stuff);
            CHECK(mesh_add(world, m, vertices, 8, triangles, 6).id > 0);
            body = dem_sphere_add(world, m, DEM_R(0.5), at(s[0], s[1], 0.5 - 1.0/2000));
            set_motion(world, body, at(s[2], s[3], 0), at(0, 0, 0));
            for (k = 0; k < 1800; k++) {
                dem_body_state b;
                step(world, 1);
                b = state_of(world, body);
                dz = fmax(dz, fabs((double)b.position.z - 0.4995));
                dv = fmax(dv, length(mix(b.velocity, -1, at(s[2], s[3], 0))));
                df = fmax(df, fabs((double)b.force.z - 1));
            }
            CHECK_NEAR(dz, 0, 1e-9);
            CHECK_NEAR(dv, 0, 1e-9);
            CHECK_NEAR(df, 0, 1e-6);          /* k dz: 2000 times the height's tolerance */
            dem_world_destroy(world);
        }
    }
    TEST("MercuryDPM rolling over triangles: with friction the ball moves as on a plane, and "
         "contact history carries over") {
        static const dem_real vertices[] = {0, -1, 0, 0, 1, 0, 1, -1, 0, 1, 0, 0, 1, 1, 0, 2, -1, 0,
                                            2, 0, 0, 2, 1, 0};
        static const int32_t triangles[] = {0, 1, 4, 0, 2, 4, 2, 3, 6, 2, 5, 6, 3, 4, 7, 3, 6, 7};
        const dem_material_desc stuff = linear_stuff(6/pi, 2000, 1, 0.4);
        dem_body_state last[2];
        int i, k;
        for (k = 0; k < 3; k++) { /* along the row of edges, over the vertex, obliquely */
            for (i = 0; i < 2; i++) {
                dem_world_desc desc = one_thread(1e-3);
                dem_world *world;
                dem_material m;
                dem_body body;
                desc.gravity.z = -1;
                desc.normal_law = DEM_NORMAL_LINEAR;
                world = dem_world_create(&desc);
                m = dem_material_add(world, &stuff);
                if (i) dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
                else mesh_add(world, m, vertices, 8, triangles, 6);
                body = dem_sphere_add(world, m, DEM_R(0.5), at(2, k == 1 ? 0 : -0.5, 0.4995));
                set_motion(world, body, at(-1, k == 2 ? 0.4 : 0, 0), at(0, 0, 0));
                step(world, 1900);            /* slides for .7 s, then rolls */
                last[i] = state_of(world, body);
                dem_world_destroy(world);
            }
            CHECK_NEAR(length(mix(last[0].position, -1, last[1].position)), 0, 1e-9);
            CHECK_NEAR(length(mix(last[0].velocity, -1, last[1].velocity)), 0, 1e-9);
            CHECK_NEAR(length(mix(last[0].spin, -1, last[1].spin)), 0, 1e-9);
            CHECK_REL(last[0].velocity.x, -5.0/7, 0.02);     /* and it does roll in the end */
        }
    }

    TEST("DEM-Engine issue 73: a drop in a box of triangles and in one of planes rebounds alike") {
        const dem_material_desc stuff = hertz_stuff(2600, 1e8, 0.3, 0.5, 0.3);
        double impact[2], rebound[2];
        int i, k;
        for (i = 0; i < 2; i++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            const double r = 1e-3, side = 0.025;
            dem_world *world;
            dem_material m;
            dem_body body;
            desc.threads = 1;
            desc.dt = DEM_R(1e-6);
            desc.gravity.y = DEM_R(-9.81);
            world = dem_world_create(&desc);
            m = dem_material_add(world, &stuff);
            if (i) {
                dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 1, 0));
                dem_wall_plane_add(world, m, at(0, 2*side, 0), at(0, -1, 0));
                dem_wall_plane_add(world, m, at(-side, 0, 0), at(1, 0, 0));
                dem_wall_plane_add(world, m, at(side, 0, 0), at(-1, 0, 0));
                dem_wall_plane_add(world, m, at(0, 0, -side), at(0, 0, 1));
                dem_wall_plane_add(world, m, at(0, 0, side), at(0, 0, -1));
            } else {                          /* corner c: bits x, y, z */
                static const int32_t faces[] = {0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6,
                                                0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3,
                                                0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5};
                dem_real corners[24];
                for (k = 0; k < 8; k++) {
                    corners[3*k] = (dem_real)(k & 1 ? side : -side);
                    corners[3*k + 1] = (dem_real)(k & 2 ? 2*side : 0);
                    corners[3*k + 2] = (dem_real)(k & 4 ? side : -side);
                }
                CHECK(mesh_add(world, m, corners, 8, faces, 12).id > 0);
            }
            body = dem_sphere_add(world, m, (dem_real)r, at(0, 0.02, 0));
            impact[i] = rebound[i] = 0;
            for (k = 0; k < 100000 && rebound[i] <= 0; k++) {
                dem_body_state s;
                step(world, 1);
                s = state_of(world, body);
                if ((double)s.position.y <= r) continue;
                if (s.velocity.y > 0) rebound[i] = (double)s.velocity.y;
                else impact[i] = sqrt(pow((double)s.velocity.y, 2) +
                                      2*9.81*((double)s.position.y - r));
            }
            CHECK_NEAR(state_of(world, body).velocity.x, 0, 1e-12);
            CHECK_NEAR(state_of(world, body).velocity.z, 0, 1e-12);
            dem_world_destroy(world);
        }
        CHECK_REL(impact[0], 0.6106, 1e-3);
        CHECK_REL(rebound[0], 0.3053, 1e-3);
        CHECK_REL(rebound[1], 0.3053, 1e-3);
        CHECK_REL(rebound[0], rebound[1], 1e-9);
    }

    /* Steps of 3e-4 rad, far more than a simulation's. 1e-10 per turn is the published case; also
       checked is where the force points after the turn: when the contact plane is also twisted that
       is of second order, .4 (angle)^2 per turn. */
    TEST("co-rotation (ON-DEM shear test): the tangential force of a user-defined law rotates "
         "with its contact without work") {
        static const double axes[][3] = {{0, 1, 0}, {0, 0, 1}, {0, 2, -1}, {1, 2, 3}, {2, 0, 1},
                                         {1, 0, 0}};
        size_t i;
        for (i = 0; i < sizeof axes/sizeof *axes; i++)
            check_turned(turn_once(at(axes[i][0], axes[i][1], axes[i][2]), 1, 20000),
                         fabs(axes[i][0]) > 0);
    }
    TEST("co-rotation (ON-DEM shear test): the stored spring of friction rotates with its contact "
         "without work") {
        static const double axes[][3] = {{0, 1, 0}, {0, 0, 1}, {1, 2, 3}};
        size_t i;
        for (i = 0; i < sizeof axes/sizeof *axes; i++)
            check_turned(turn_once(at(axes[i][0], axes[i][1], axes[i][2]), 0, 20000),
                         fabs(axes[i][0]) > 0);
    }

    TEST("size ratio 1:100 (Ogarko & Luding): every search finds the pairs that brute force "
         "finds") {
        static uint32_t found[2*20000], right[2*20000];
        int method;
        for (method = DEM_SEARCH_ALL_PAIRS; method <= DEM_SEARCH_HIERARCHICAL; method++) {
            const dem_material_desc stuff = hertz_stuff(2500, 1e7, 0.25, 0.8, 0.3);
            dem_world_desc desc = one_thread(1e-6);
            uint64_t random = 7;
            dem_world *world;
            dem_material m;
            dem_body big;
            dem_body_state s;
            int i, n = 0, expected, round;
            desc.search = (dem_search)method;
            desc.skin = DEM_R(0.005);
            world = dem_world_create(&desc);
            m = dem_material_add(world, &stuff);
            big = dem_sphere_add(world, m, 1, at(0, 0, 0));
            s = state_of(world, big);
            s.fixed = 1;
            dem_body_set(world, big, &s);
            while (n < 1000) { /* apart from the big one; some on each other, not deep */
                const double x = 2.2*uniform(&random) - 1.1, y = 2.2*uniform(&random) - 1.1;
                const double z = 2.2*uniform(&random) - 1.1;
                const double d = sqrt(x*x + y*y + z*z);
                dem_body b;
                if (d < 1.008 || d > 1.05 || !far_from_all(world, x, y, z, 0.017)) continue;
                b = dem_sphere_add(world, m, DEM_R(0.01), at(x, y, z));
                set_motion(world, b, at(0.4*(uniform(&random) - 0.5), 0.4*(uniform(&random) - 0.5),
                                        0.4*(uniform(&random) - 0.5)), at(0, 0, 0));
                n++;
            }
            for (round = 0; round < 5; round++) {
                CHECK_EQ(dem_candidates_rebuild(world), DEM_OK);
                i = dem_candidates_get(world, found, 20000);
                expected = pairs_by_force(world, (double)dem_counters_get(world).skin, right);
                CHECK_EQ(dem_counters_get(world).search, method);
                CHECK_EQ(i, expected);
                CHECK(expected > 100);
                if (i != expected) continue;
                pairs_sort(found, i);
                CHECK(memcmp(found, right, (size_t)i*2*sizeof *found) == 0);
                step(world, 400);
                expected = pairs_by_force(world, 0, right);
                CHECK_EQ(dem_contacts_get(world, 0, 0), expected);
            }
            dem_world_destroy(world);
        }
    }

    TEST("MFiX DEM02: a ball with restitution one bounces for 10 s without losing or gaining "
         "height") {
        const dem_material_desc stuff = linear_stuff(2600, 5e4, 1, 0);
        const double m = 2600*4.0/3*pi*1e-3, contact = pi*sqrt(m/5e4);
        dem_world_desc desc = one_thread(contact/2000);
        dem_world *world;
        dem_body body;
        dem_material mat;
        double top = 0.5, worst = 0, last = 0.5, sum_h = 0, sum_k = 0, sum_kk = 0, sum_kh = 0;
        int bounces = 0, was_down = 1;
        desc.gravity.z = DEM_R(-9.81);
        desc.normal_law = DEM_NORMAL_LINEAR;
        world = dem_world_create(&desc);
        mat = dem_material_add(world, &stuff);
        dem_wall_plane_add(world, mat, at(0, 0, 0), at(0, 0, 1));
        body = dem_sphere_add(world, mat, DEM_R(0.1), at(0, 0, top));
        while (dem_world_time_get(world) < 10) {
            dem_body_state s;
            step(world, 50);
            s = state_of(world, body);
            if (s.velocity.z > 0 && s.position.z > DEM_R(0.1) && was_down) {
                /* free flight is exact */
                last = (double)s.position.z + (double)(s.velocity.z*s.velocity.z)/(2*9.81);
                bounces++;
                was_down = 0;
                worst = fmax(worst, fabs(last - top)/bounces);
                sum_k += bounces;
                sum_h += last - top;
                sum_kk += (double)bounces*bounces;
                sum_kh += bounces*(last - top);
            }
            if (s.velocity.z < 0) was_down = 1;
        }
        CHECK(bounces >= 14);
        CHECK_NEAR((last - top)/bounces/top, 0, 1e-6);       /* of the height, per bounce */
        CHECK_NEAR(worst/top, 0, 1e-6);
        /* the trend */
        CHECK_NEAR((bounces*sum_kh - sum_k*sum_h)/(bounces*sum_kk - sum_k*sum_k)/top, 0, 1e-6);
        dem_world_destroy(world);
    }

    TEST("Kratos benchmarks 13 to 16: a sphere dropped exactly on a facet, edge, vertex or grid "
         "never leaves the vertical") {
        const dem_material_desc stuff = hertz_stuff(100, 1e5, 0.2, 0.9, 0.5);
        int t;
        double height = 0;
        for (t = PLANE; t >= FACET; t--) {
            dem_world_desc desc = one_thread(5e-4);
            dem_world *world;
            dem_body body;
            dem_material m;
            int i;
            double aside = 0, turn = 0;
            desc.gravity.y = DEM_R(-9.81);
            world = dem_world_create(&desc);
            m = dem_material_add(world, &stuff);
            CHECK(target_add(world, m, (target)t).id > 0);
            body = dem_sphere_add(world, m, DEM_R(0.3), at(0, 1, 0));
            for (i = 0; i < 6000; i++) {
                dem_body_state s;
                step(world, 1);
                s = state_of(world, body);
                aside = fmax(aside, fmax(fabs((double)s.velocity.x), fabs((double)s.velocity.z)));
                turn = fmax(turn, length(s.spin));
            }
            CHECK_NEAR(aside, 0, 1e-12);
            CHECK_NEAR(turn, 0, 1e-12);
            if (t == PLANE) height = (double)state_of(world, body).position.y;
            /* one push, not one per triangle */
            CHECK_NEAR(state_of(world, body).position.y, height, 1e-9);
            dem_world_destroy(world);
        }
    }
    TEST("Kratos benchmark 17: a ball rolls at 5 m/s on coarse and on fine triangles alike") {
        const dem_material_desc stuff = hertz_stuff(100, 1e5, 0.2, 0.9, 0.5);
        enum { runs = 3, samples = 80 };
        static dem_vec3 v[runs][samples], w[runs][samples];
        int t, i;
        for (t = 0; t < runs; t++) {          /* a plane, 2 triangles, 560 triangles */
            dem_world_desc desc = one_thread(2e-4);
            dem_world *world;
            dem_body body;
            dem_material m;
            const double mass = 100*4.0/3*pi*0.027;
            double sink;
            dem_coefficients c;
            desc.gravity.y = DEM_R(-9.81);
            world = dem_world_create(&desc);
            m = dem_material_add(world, &stuff);
            if (t == 0) dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 1, 0));
            else grid_floor(world, m, -1, -1, 6, 1.1, t == 1 ? 1 : 28, t == 1 ? 1 : 10);
            dem_coefficients_get(world, m, m, DEM_R(0.3), 0, &c);
            sink = pow(mass*9.81/(double)c.kn, 2.0/3);
            body = dem_sphere_add(world, m, DEM_R(0.3), at(0, 0.3 - sink, 0.013));
            set_motion(world, body, at(5, 0, 0), at(0, 0, 0));
            for (i = 0; i < samples; i++) {
                step(world, 60);
                v[t][i] = state_of(world, body).velocity;
                w[t][i] = state_of(world, body).spin;
            }
            CHECK(state_of(world, body).position.x > 3);
            dem_world_destroy(world);
        }
        for (t = 1; t < runs; t++)
            for (i = 0; i < samples; i++) {
                CHECK_NEAR(length(mix(v[t][i], -1, v[0][i]))/5, 0, 1e-9);
                CHECK_NEAR(length(mix(w[t][i], -1, w[0][i]))*0.3/5, 0, 1e-9);
            }
        CHECK_REL(v[0][samples - 1].x, 25.0/7, 1e-3); /* it rolls by then: 5/7 of the first speed */
    }
    TEST("an oblique impact never gains energy, nor does sliding return any, for every law with a "
         "spring") {
        static const double restitution[3] = {0.1, 0.3, 0.7}, tangent[2] = {0.5, 2};
        int normal, law, i, j, k;
        for (normal = DEM_NORMAL_HERTZ; normal <= DEM_NORMAL_HYSTERETIC; normal++)
            for (law = DEM_TANGENT_SPRING; law <= DEM_TANGENT_MINDLIN_RESCALED; law++)
                for (i = 0; i < 3; i++) for (j = 0; j < 2; j++) {
                    dem_world_desc desc = one_thread(0);
                    dem_world *world;
                    dem_material stuff;
                    dem_material_desc m = hertz_stuff(2500, 1e8, 0.3, restitution[i], 0.5);
                    dem_ledger l;
                    dem_advice advice;
                    double before, slide = 0;
                    desc.allow_large_dt = 0;
                    desc.normal_law = (dem_normal_law)normal;
                    desc.tangent_law = (dem_tangent_law)law;
                    desc.ledger = 1;
                    if (normal != DEM_NORMAL_HERTZ) m.stiffness = DEM_R(1e5);
                    /* at t_c/100: at t_c/50 the step in which the two meet makes 1.1e-4 in one case
                       of 54, at t_c/200 2e-5 */
                    for (k = 0, world = 0; k < 2; k++) {
                        dem_world_destroy(world);
                        world = dem_world_create(&desc);
                        stuff = dem_material_add(world, &m);
                        set_motion(world, dem_sphere_add(world, stuff, DEM_R(0.005), at(0, 0, 0)),
                                   at(1, tangent[j], 0), at(0, 0, 0));
                        dem_sphere_add(world, stuff, DEM_R(0.005), at(0.0101, 0, 0));
                        dem_step_advice_get(world, &advice);
                        desc.dt = advice.dt/2;
                    }
                    before = dem_totals_get(world).kinetic;
                    for (k = 0; k < 800; k++) {
                        step(world, 1);
                        l = dem_ledger_get(world);
                        CHECK((l.kinetic + l.rotational + l.elastic)/before < 1 + 1e-4);
                        CHECK(l.slide >= slide);
                        slide = l.slide;
                    }
                    CHECK(l.normal/before > 0.03);
                    CHECK_NEAR(l.residual/before, 0, 6e-3);     /* e = .1 at the worst */
                    dem_world_destroy(world);
                }
    }
    return test_end();
}
