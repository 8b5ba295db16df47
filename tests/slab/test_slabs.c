/* Slabs: a scene dealt along one axis does what it does in one world. Nothing is lost or doubled,
   memory migrates, borders follow the work, and bits hang on the number of slabs alone. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"
#include "../walk.h"

static dem_slabs *deal(dem_world *world, int axis, int count) {
    dem_slabs_desc desc = DEM_SLABS_DESC;
    dem_slabs *slabs;
    desc.axis = axis;
    desc.count = count;
    slabs = dem_slabs_create(world, &desc);
    if (!slabs) puts(dem_world_error_get(world));
    return slabs;
}
static dem_result go(dem_slabs *slabs, int steps) {
    const dem_result result = dem_slabs_step(slabs, steps);
    if (result != DEM_OK) puts(dem_slabs_error_get(slabs));
    return result;
}
static dem_result collect(dem_slabs *slabs, dem_world *world) {
    const dem_result result = dem_slabs_collect(slabs, world);
    if (result != DEM_OK) puts(dem_slabs_error_get(slabs));
    return result;
}
/* A close packing of 1024 hard balls of 1 mm, pressed into each other by 1 % of their radius, periodic: 12 contacts each.
   One of them has a speed (m/s); all are pulled along (m/s2). */
static dem_world *crystal(double dt, double speed, double pull) {
    const double radius = 1e-3, edge = 2*radius*0.995*sqrt(2.0);
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material stuff;
    static dem_real x[3*1024], v[3*1024];
    int i, l, n = 0;
    desc.dt = (dem_real)dt;
    desc.threads = 1;
    desc.impact_speed = DEM_R(1e-4);
    desc.gravity.x = (dem_real)pull;
    desc.domain = box_of(0, 0, 0, 16*edge, 4*edge, 4*edge);
    for (i = 0; i < 3; i++) desc.boundary[i] = DEM_BOUNDARY_PERIODIC;
    world = dem_world_create(&desc);
    stuff = scene_material(world, 1e9, 1, 0.5, 0);
    for (i = 0; i < 256; i++)
        for (l = 0; l < 4; l++, n += 3) {
            x[n] = (dem_real)((i/16 + (l == 1 || l == 2 ? 0.5 : 0) + 0.1)*edge);
            x[n + 1] = (dem_real)((i/4%4 + (l == 1 || l == 3 ? 0.5 : 0) + 0.1)*edge);
            x[n + 2] = (dem_real)((i%4 + (l == 2 || l == 3 ? 0.5 : 0) + 0.1)*edge);
            v[n] = v[n + 1] = v[n + 2] = 0;
        }
    v[1500] = (dem_real)speed;
    dem_spheres_add(world, stuff, 1024, x, v, 0, (dem_real)radius);
    return world;
}
/* Digest with contact memory: that is in it only while there is a list. */
static uint64_t digest(dem_world *world) {
    dem_candidates_rebuild(world);
    return dem_world_hash_get(world);
}

/* 600 grains of three radii in a drum about x that turns, with lifters, between end planes or
   periodic: contacts from the first step on. */
typedef struct drum_desc {
    int periodic, threads, integrator;
    dem_force_fn force;
} drum_desc;
static const drum_desc DRUM = {0, 1, 0, 0};
static dem_world *drum(const drum_desc *d) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material glass;
    dem_motion motion = DEM_MOTION;
    dem_wall wall;
    dem_real x[3*600], v[3*600], r[600];
    uint64_t seed = 3;
    int i, k;
    desc.gravity = at(0, 0, -9.81);
    desc.dt = DEM_R(1e-5);
    desc.ledger = 1;
    desc.threads = d->threads;
    desc.integrator = (dem_integrator)d->integrator;
    desc.force = d->force;
    desc.impact_speed = 1;
    if (d->periodic) {
        desc.boundary[0] = DEM_BOUNDARY_PERIODIC;
        desc.domain = box_of(0, -1, -1, 0.048, 1, 1);
    }
    world = dem_world_create(&desc);
    glass = scene_material(world, 1e6, 0.6, 0.4, 0.05);
    wall = dem_wall_cylinder_add(world, glass, at(0, 0.006, 0.006), at(1, 0, 0), DEM_R(0.0066), 1);
    motion.kind = DEM_MOTION_ROTATING;
    motion.axis = at(1, 0, 0);
    motion.point = at(0, 0.006, 0.006);
    motion.speed = 20;
    dem_wall_motion_set(world, wall, &motion);
    for (k = 0; k < 3; k++) {                  /* lifters: blades across the drum */
        dem_mesh mesh;
        dem_real p[12];
        int32_t t[6] = {0, 1, 2, 0, 2, 3};
        const double c = cos(2.1*k), s = sin(2.1*k);
        for (i = 0; i < 4; i++) {
            const double out = i < 2 ? 0.0058 : 0.0066;
            p[3*i] = DEM_R(i == 1 || i == 2 ? 0.05 : -0.002);
            p[3*i + 1] = (dem_real)(0.006 + out*c);
            p[3*i + 2] = (dem_real)(0.006 + out*s);
        }
        mesh.vertex_count = 4; mesh.triangle_count = 2;
        mesh.vertices = p; mesh.triangles = t;
        wall = dem_wall_mesh_add(world, glass, &mesh);
        dem_wall_motion_set(world, wall, &motion);
    }
    if (!d->periodic) {
        dem_wall_plane_add(world, glass, at(0, 0, 0), at(1, 0, 0));
        dem_wall_plane_add(world, glass, at(0.048, 0, 0), at(-1, 0, 0));
    }
    for (i = 0; i < 600; i++) {                /* 24 x 5 x 5 places 2 mm apart, radii 0.95..1.05 */
        x[3*i] = (dem_real)(0.002*(i%24) + 0.001);
        x[3*i + 1] = (dem_real)(0.002*(i/24%5) + 0.002);
        x[3*i + 2] = (dem_real)(0.002*(i/120) + 0.002);
        r[i] = (dem_real)(1e-3*(0.95 + 0.1*scene_random(&seed)));
        for (k = 0; k < 3; k++) v[3*i + k] = (dem_real)(0.2*(scene_random(&seed) - 0.5));
    }
    dem_spheres_add(world, glass, 600, x, v, r, 0);
    for (i = 0; i < 600; i += 97) {            /* some never move */
        dem_body_state state = scene_state(world, dem_body_id_get(world, i));
        state.fixed = 1;
        dem_body_set(world, dem_body_id_get(world, i), &state);
    }
    return world;
}
/* Largest distance between the same grains of two worlds, image by image. */
static double apart(const dem_world *a, const dem_world *b) {
    const demi_periods p = demi_periods_of(a);
    double most = 0;
    int k, e;
    for (k = 0; k < a->bodies.slot_count; k++) {
        const int i = a->bodies.slot_index[k], j = b->bodies.slot_index[k];
        if ((i < 0) != (j < 0)) return 1e300;
        for (e = 0; e < 3 && i >= 0; e++) {
            const dem_real d = demi_image(b->bodies.pos[4*j + e] - a->bodies.pos[4*i + e], p.half[e],
                                          p.period[e]);
            most = DEMI_MAX(most, fabs((double)d));
        }
    }
    return most;
}
/* Is every grain at home in one slab, and a ghost nowhere but in the one above? */
static int whole(const dem_slabs *s, int count) {
    int *homes = (int *)calloc((size_t)count, sizeof(int)), i, k, right = homes != 0;
    for (k = 0; k < s->local && right; k++) {
        const dem_world *w = s->slabs[k].world;
        for (i = 0; i < w->bodies.count; i++) if (!demi_is_ghost(w, i)) homes[w->bodies.slot[i]] += k + 1;
    }
    for (k = 0; k < s->local && right; k++) {
        const dem_world *w = s->slabs[k].world;
        const int below = (k + s->local - 1)%s->local + 1;
        for (i = 0; i < w->bodies.count; i++)
            if (demi_is_ghost(w, i)) right = right && homes[w->bodies.slot[i]] == below;
    }
    for (k = 0, i = 0; k < s->local && right; k++) {
        dem_slab slab;
        dem_slab_get(s, k, &slab);
        i += slab.grains;
    }
    right = right && i == count;
    for (i = 0; i < count && right; i++) right = homes[i] >= 1 && homes[i] <= s->local;
    free(homes);
    return right;
}
static double energy_of(const dem_totals *t) { return t->kinetic + t->rotational; }

static dem_vec3 updraught(dem_vec3 x, dem_vec3 v, dem_real r, dem_real m, double t, void *user) {
    (void)r; (void)t; (void)user;
    return dem_vec3_make(-v.x*DEM_R(1e-4), m*x.y*100, m*3);
}
/* Pushes towards the line y = z = 0. */
static dem_vec3 squeeze(dem_vec3 x, dem_vec3 v, dem_real r, dem_real m, double t, void *user) {
    (void)v; (void)r; (void)m; (void)t; (void)user;
    return dem_vec3_make(0, -10*x.y, -10*x.z);
}

/* A plate at z = -0.02, with an edge along its middle. */
static void scene_plate(dem_world *world, dem_material glass) {
    dem_real p[12] = {DEM_R(-0.1), DEM_R(-0.1), DEM_R(-0.02), DEM_R(0.2), DEM_R(-0.1),
                      DEM_R(-0.02), DEM_R(0.2), DEM_R(0.1), DEM_R(-0.02), DEM_R(-0.1), DEM_R(0.1),
                      DEM_R(-0.02)};
    int32_t t[6] = {0, 1, 2, 0, 2, 3};
    dem_mesh mesh;
    mesh.vertex_count = 4; mesh.triangle_count = 2;
    mesh.vertices = p; mesh.triangles = t;
    dem_wall_mesh_add(world, glass, &mesh);
}

/* Heaps along x: `tilted` lets all grains run to x = 0. */
static dem_world *crate(double gx, double gz, dem_boundary end, int count, scene_memory *c) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material glass;
    desc.gravity = at(gx, 0, gz);
    desc.threads = 1;
    desc.dt = DEM_R(2e-5);
    desc.impact_speed = 1;
    desc.ledger = 1;
    desc.boundary[0] = end;
    desc.domain = box_of(0, -1, -1, 0.06, 1, 1);
    if (c) scene_memory_use(c, &desc);
    world = dem_world_create(&desc);
    glass = scene_material(world, 1e6, 0.5, 0.3, 0);
    if (end != DEM_BOUNDARY_PERIODIC) {
        if (end == DEM_BOUNDARY_OPEN) dem_wall_plane_add(world, glass, at(0, 0, 0), at(1, 0, 0));
        dem_wall_plane_add(world, glass, at(0.06, 0, 0), at(-1, 0, 0));
    }
    dem_wall_plane_add(world, glass, at(0, 0, 0), at(0, 1, 0));
    dem_wall_plane_add(world, glass, at(0, 0.012, 0), at(0, -1, 0));
    dem_wall_plane_add(world, glass, at(0, 0, 0), at(0, 0, 1));
    dem_wall_plane_add(world, glass, at(0, 0, 0.012), at(0, 0, -1));
    dem_spheres_fill(world, glass, DEM_R(1e-3), dem_region_make(box_of(0, 0, 0, 0.06, 0.012, 0.012)), count, 7);
    return world;
}

/* Elastic grains of three radii in a box of planes, or periodic on all axes. */
static dem_world *gas(int periodic, int threads) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material glass;
    uint64_t seed = 11;
    int i, k;
    desc.dt = DEM_R(8e-6);
    desc.threads = threads;
    desc.impact_speed = 1;
    for (k = 0; k < 3 && periodic; k++) desc.boundary[k] = DEM_BOUNDARY_PERIODIC;
    desc.domain = box_of(0, 0, 0, 0.05, 0.016, 0.016);
    world = dem_world_create(&desc);
    glass = scene_material(world, 1e6, 1, 0, 0);
    for (i = 0; i < 6 && !periodic; i++)
        dem_wall_plane_add(world, glass, i < 3 ? at(0, 0, 0) : at(0.05, 0.016, 0.016),
                      at(i == 0 ? 1 : i == 3 ? -1 : 0, i == 1 ? 1 : i == 4 ? -1 : 0,
                         i == 2 ? 1 : i == 5 ? -1 : 0));
    for (k = 2; k >= 0; k--)
        dem_spheres_fill(world, glass, (dem_real)(5e-4*(1 + k)), dem_region_make(desc.domain), 40*(3 - k),
                         (uint64_t)k + 1);
    for (i = 0; i < world->bodies.count; i++)
        scene_move(world, dem_body_id_get(world, i),
                   scene_at(&seed, 1, -0.5, 1, -0.5, 1, -0.5), at(0, 0, 0));
    return world;
}
/* Ellipsoids, clusters and spheres, which run along a floor of triangles or over a sieve that
   shakes; orientations are followed, energies booked, a field averages. */
enum { ON_FLOOR, ON_SIEVE };
static dem_world *mixture(int on, dem_boundary end, int threads, int each, scene_memory *c) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_field_desc field;
    dem_cluster_desc two = DEM_CLUSTER_DESC;
    const dem_box room = box_of(0, 0, 0.001, 0.06, 0.012, 0.014);
    const dem_real centres[] = {DEM_R(-5e-4), 0, 0, DEM_R(5e-4), 0, 0};
    dem_world *world;
    dem_material glass;
    desc.gravity = at(-30, 0, -60);
    desc.threads = threads;
    desc.dt = DEM_R(1e-5);
    desc.impact_speed = 1;
    desc.ledger = 1;
    desc.orientations = 1;
    desc.boundary[0] = end;
    desc.domain = box_of(0, -1, -1, 0.06, 1, 1);
    if (c) scene_memory_use(c, &desc);
    world = dem_world_create(&desc);
    glass = scene_material(world, 1e6, 0.5, 0.4, 0.02);
    if (end != DEM_BOUNDARY_PERIODIC) {
        dem_wall_plane_add(world, glass, at(0, 0, 0), at(1, 0, 0));
        dem_wall_plane_add(world, glass, at(0.06, 0, 0), at(-1, 0, 0));
    }
    dem_wall_plane_add(world, glass, at(0, 0, 0), at(0, 1, 0));
    dem_wall_plane_add(world, glass, at(0, 0.012, 0), at(0, -1, 0));
    if (on == ON_SIEVE) {
        dem_sieve_desc sieve = DEM_SIEVE_DESC;
        dem_motion shake = DEM_MOTION;
        sieve.kind = DEM_SIEVE_WIRES;
        sieve.aperture = DEM_R(1.5e-3);
        sieve.bar = DEM_R(5e-4);
        shake.kind = DEM_MOTION_OSCILLATING;
        shake.velocity = at(0, 0, 1);
        shake.amplitude = DEM_R(2e-4);
        shake.frequency = 50;
        dem_wall_motion_set(world, dem_wall_sieve_add(world, glass, &sieve), &shake);
    } else {
        dem_real p[12] = {DEM_R(-0.06), DEM_R(-0.01), 0, DEM_R(0.12), DEM_R(-0.01), 0, DEM_R(0.12),
                          DEM_R(0.03), 0, DEM_R(-0.06), DEM_R(0.03), 0};
        int32_t t[6] = {0, 1, 2, 0, 2, 3};
        dem_mesh mesh;
        mesh.vertex_count = 4; mesh.triangle_count = 2;
        mesh.vertices = p; mesh.triangles = t;
        dem_wall_mesh_add(world, glass, &mesh);
        dem_bodies_fill(world, glass, dem_shape_ellipsoid_add(world, at(1.2e-3, 8e-4, 6e-4)),
                        dem_region_make(room), each, 5);
    }
    two.count = 2;
    two.positions = centres;
    two.radius = DEM_R(7e-4);
    dem_bodies_fill(world, glass, dem_shape_cluster_add(world, &two), dem_region_make(room), each, 6);
    dem_spheres_fill(world, glass, DEM_R(8e-4), dem_region_make(room), each, 7);
    memset(&field, 0, sizeof field);
    field.box = room;
    field.cells[1] = field.cells[2] = 1;
    field.cells[0] = 3;
    field.interval = 1e-3;
    dem_field_add(world, &field);
    return world;
}
/* Where bits are compared: a gas, whose sums are of one or two forces and hide their order; a heap
   that runs to one side, whose borders move; bodies of all shapes on triangles and on a sieve. */
enum { GAS, HEAP, OUTLETS, FED, FED_RING, PRESSED, SHAPES, SHAPES_RING, SIEVE, BITS };
/* The heap, with two outlets that let grains of it out: one stays, one shakes with a plane. */
static dem_world *leaking(void) {
    dem_world *world = crate(-30, -1, DEM_BOUNDARY_OPEN, 200, 0);
    dem_outlet_desc d;
    dem_motion shake = DEM_MOTION;
    dem_material glass;
    glass.id = 1;
    memset(&d, 0, sizeof d);
    d.box = box_of(0.01, 0, 0, 0.016, 0.012, 0.003);
    d.wanted_min = DEM_R(5e-4);
    d.class_count = 1;
    d.radius[0] = DEM_R(1e-3);
    CHECK_EQ(dem_outlet_add(world, &d).id, 1);
    d.frame = dem_wall_plane_add(world, glass, at(0, 0, -0.01), at(0, 0, 1));
    d.box = box_of(0.03, 0, 0.01, 0.035, 0.012, 0.013);
    shake.kind = DEM_MOTION_OSCILLATING;
    shake.velocity = at(1, 0, 0);
    shake.amplitude = DEM_R(0.004);
    shake.frequency = 30;
    CHECK_EQ(dem_wall_motion_set(world, d.frame, &shake), DEM_OK);
    CHECK_EQ(dem_outlet_add(world, &d).id, 2);
    /* one that only counts, shaken like the other: grains come in and go back */
    d.box = box_of(0.02, 0, -1, 0.03, 0.012, 1);
    d.keep = 1;
    CHECK_EQ(dem_outlet_add(world, &d).id, 3);
    return world;
}
/* Grains of three classes rain on the heap, all along the crate: 1000 a second. */
static dem_feed rain(dem_world *world) {
    dem_feed_desc d;
    memset(&d, 0, sizeof d);
    d.material.id = 1;
    d.box = box_of(0, 0.001, 0.006, 0.06, 0.011, 0.011);
    d.class_count = 3;
    d.radius[0] = DEM_R(1e-3); d.radius[1] = DEM_R(9e-4); d.radius[2] = DEM_R(8.5e-4);
    d.amount[0] = d.amount[1] = 20; d.amount[2] = 1000;
    d.limited = 1;
    d.rate = 1000;
    d.velocity = at(0, 0, -0.5);
    d.spread = DEM_R(0.1);
    d.seed = 7;
    return dem_feed_add(world, &d);
}
static dem_world *rained_on(int ring) {
    dem_world *world = ring ? crate(0, -5, DEM_BOUNDARY_PERIODIC, 200, 0) : leaking();
    CHECK_EQ(rain(world).id, 1);
    return world;
}
/* The heap below two servo walls: a plane, and one that comes from its side. */
static dem_world *pressed(void) {
    dem_world *world = crate(-30, -1, DEM_BOUNDARY_OPEN, 200, 0);
    dem_material glass;
    int i;
    glass.id = 1;
    for (i = 0; i < 2; i++) {
        dem_motion press = DEM_MOTION;
        press.kind = DEM_MOTION_SERVO;
        press.velocity = i ? at(-0.2, 0, 0) : at(0, 0, -0.2);
        press.load = DEM_R(0.05);
        CHECK_EQ(dem_wall_motion_set(world, dem_wall_plane_add(world, glass, i ? at(0.06, 0, 0) : at(0, 0, 0.013),
                                                               i ? at(-1, 0, 0) : at(0, 0, -1)), &press), DEM_OK);
    }
    return world;
}
static dem_world *bits_world(int scene, int threads) {
    dem_world *world = scene == OUTLETS ? leaking() : scene == GAS ? gas(1, threads) : scene == PRESSED ? pressed()
        : scene == FED || scene == FED_RING ? rained_on(scene == FED_RING)
        : scene == HEAP ? crate(-30, -1, DEM_BOUNDARY_OPEN, 200, 0)
        : mixture(scene == SIEVE ? ON_SIEVE : ON_FLOOR, scene == SHAPES_RING
                  ? DEM_BOUNDARY_PERIODIC : DEM_BOUNDARY_OPEN, threads, 150, 0);
    world->desc.threads = threads;
    return world;
}
static uint64_t bits_of(int scene, int threads, int count, int steps) {
    dem_world *world = bits_world(scene, threads);
    dem_slabs_desc desc = DEM_SLABS_DESC;
    dem_slabs *slabs;
    uint64_t hash;
    desc.count = count;
    desc.balance_interval = 1;
    slabs = dem_slabs_create(world, &desc);
    CHECK_EQ(go(slabs, steps), DEM_OK);
    CHECK(dem_slabs_counters_get(slabs).migrated > 0);
    CHECK(scene != HEAP || dem_slabs_counters_get(slabs).border_moves > 0);
    CHECK_EQ(collect(slabs, world), DEM_OK);
    hash = digest(world);
    dem_slabs_destroy(slabs);
    dem_world_destroy(world);
    return hash;
}

#if DEMI_OPENMP
/* Processes played by threads: what one writes into its place of the ring, its neighbour reads
   after all have written. */
enum { RANKS = 3 };
typedef struct ring {
    const void *lower[RANKS], *upper[RANKS];
    size_t lower_size[RANKS], upper_size[RANKS];
    double *values[RANKS];
    int surprises;                  /* sizes that were not as awaited */
} ring;
static ring ring_now;
static int ring_exchange(const void *to_lower, size_t to_lower_size, void *from_lower,
                         size_t from_lower_size, const void *to_upper, size_t to_upper_size,
                         void *from_upper, size_t from_upper_size, void *user) {
    const int rank = omp_get_thread_num();
    const int below = (rank + RANKS - 1)%RANKS, above = (rank + 1)%RANKS;
    (void)user;
    ring_now.lower[rank] = to_lower;
    ring_now.upper[rank] = to_upper;
    ring_now.lower_size[rank] = to_lower_size;
    ring_now.upper_size[rank] = to_upper_size;
    #pragma omp barrier
    if (ring_now.upper_size[below] != from_lower_size ||
        ring_now.lower_size[above] != from_upper_size) {
        #pragma omp atomic
        ring_now.surprises++;
    }
    if (from_lower_size)
        memcpy(from_lower, ring_now.upper[below], from_lower_size);
    if (from_upper_size) memcpy(from_upper, ring_now.lower[above], from_upper_size);
    #pragma omp barrier
    return 0;
}
static int ring_reduce(double *values, int count, int sum, void *user) {
    double all[512];
    int i, k;
    (void)user;
    ring_now.values[omp_get_thread_num()] = values;
    #pragma omp barrier
    for (i = 0; i < count && i < 512; i++) {
        all[i] = ring_now.values[0][i];
        for (k = 1; k < RANKS; k++)
            all[i] = sum ? all[i] + ring_now.values[k][i]
                         : DEMI_MAX(all[i], ring_now.values[k][i]);
    }
    #pragma omp barrier
    if (count <= 512) memcpy(values, all, (size_t)count*sizeof(double));
    return count > 512;
}
/* Slabs held by three processes; all must come to the same world. */
static uint64_t ring_bits(int scene, int count, int steps, int *ranks) {
    uint64_t hash[RANKS] = {0, 0, 0};
    int good[RANKS] = {0, 0, 0}, team = 0;
    #pragma omp parallel num_threads(RANKS)
    {
        const int rank = omp_get_thread_num();
        if (omp_get_num_threads() == RANKS) {
            dem_world *world = bits_world(scene, 1);
            dem_slabs_desc desc = DEM_SLABS_DESC;
            dem_slabs *slabs;
            desc.count = count;
            desc.balance_interval = 1;
            desc.first = rank*count/RANKS;
            desc.local = (rank + 1)*count/RANKS - desc.first;
            desc.transport.exchange_fn = ring_exchange;
            desc.transport.reduce_fn = ring_reduce;
            slabs = dem_slabs_create(world, &desc);
            good[rank] = slabs && dem_slabs_step(slabs, steps/2) == DEM_OK &&
                         dem_slabs_collect(slabs, world) == DEM_OK &&   /* in passing */
                         dem_slabs_step(slabs, steps - steps/2) == DEM_OK &&
                         dem_slabs_collect(slabs, world) == DEM_OK;
            hash[rank] = digest(world);
            dem_slabs_destroy(slabs);
            dem_world_destroy(world);
            if (rank == 0) team = RANKS;
        }
    }
    *ranks = team;
    if (team == RANKS) CHECK(good[0] && good[1] && good[2]);
    CHECK_EQ(ring_now.surprises, 0);
    CHECK(hash[1] == hash[0] && hash[2] == hash[0]);
    return hash[0];
}
#endif

/* 60 grains that roll in a box, pressed together, with histories of friction and of rolling friction. */
static dem_world *bed(dem_rolling_law rolling) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material glass;
    int i;
    desc.threads = 1;
    desc.dt = DEM_R(1e-5);
    desc.ledger = 1;
    desc.gravity = at(3, 0, -9.81);
    desc.orientations = 1;                     /* without them no contact of a cluster has a history of its own */
    desc.rolling_law = rolling;
    world = dem_world_create(&desc);
    glass = scene_material(world, 1e7, 0.5, 0.4, 0.2);
    dem_wall_plane_add(world, glass, at(0, 0, 0), at(0, 0, 1));
    for (i = 0; i < 4; i++)
        dem_wall_plane_add(world, glass, i < 2 ? at(-0.006, -0.006, 0) : at(0.046, 0.036, 0),
                           at(i == 0 ? 1 : i == 2 ? -1 : 0, i == 1 ? 1 : i == 3 ? -1 : 0, 0));
    for (i = 0; i < 60; i++)
        dem_sphere_add(world, glass, DEM_R(0.005), at(i%5*0.00998 + i/20*0.0004, i/5%4*0.00998 + i/20*0.0003,
                                                      0.00499 + i/20*0.00997));
    return world;
}
/* That bed after some steps and then a change of its laws. */
enum { NO_CHANGE, NO_FRICTION, NO_ROLLING, STATIC, SPINNING, CLUSTERS, ROLLING_LAW, LAW_CHANGES };
static dem_world *bed_changed(int change) {
    static const char name[] = "build/tmp/bed.ckpt";
    static const dem_real two[6] = {0, 0, 0, DEM_R(0.003), 0, 0};
    dem_world *world = bed(DEM_ROLLING_AUTO), *fresh;
    dem_cluster_desc cluster = DEM_CLUSTER_DESC;
    dem_material glass;
    dem_pair pair;
    glass.id = 1;
    CHECK_EQ(scene_step(world, 300), DEM_OK);
    dem_pair_get(world, glass, glass, &pair);
    if (change == NO_FRICTION) pair.friction = pair.friction_static = 0;
    if (change == NO_ROLLING) pair.rolling_friction = 0;
    if (change == STATIC) pair.friction_static = DEM_R(0.6);
    if (change == SPINNING) pair.spinning_friction = DEM_R(0.2);
    if (change >= NO_FRICTION && change <= SPINNING) CHECK_EQ(dem_pair_set(world, glass, glass, &pair), DEM_OK);
    cluster.count = 2;
    cluster.positions = two;
    cluster.radius = DEM_R(0.003);
    if (change == CLUSTERS) CHECK(dem_shape_cluster_add(world, &cluster).id > 0);
    if (change != ROLLING_LAW) return world;
    CHECK_EQ(dem_checkpoint_write(world, name), DEM_OK);
    fresh = bed(DEM_ROLLING_NONE);
    CHECK_EQ(dem_checkpoint_read_changed(fresh, name, "rolling_law"), DEM_OK);
    dem_world_destroy(world);
    remove(name);
    return fresh;
}
/* Largest difference of a spin between the same grains of two worlds, rad/s. */
static double spin_apart(const dem_world *a, const dem_world *b) {
    double most = 0;
    int i;
    for (i = 0; i < a->bodies.count; i++) {
        const dem_body body = dem_body_id_get(a, i);
        most = fmax(most, fabs((double)scene_state(a, body).spin.y - (double)scene_state(b, body).spin.y));
    }
    return most;
}

/* Cubes of 2 mm that slide on two boxes side by side; the second box rises from 3 ms on. */
static dem_world *gate(scene_memory *c) {
    static const int32_t t[36] = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4, 1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0,
                                  4, 3, 4, 7};
    dem_world_desc d = DEM_WORLD_DESC;
    dem_motion rise = DEM_MOTION;
    dem_material m;
    dem_shape cube;
    dem_world *w;
    dem_wall box = {0};
    int i, k;
    d.gravity = at(0, 0, -9.81);
    d.dt = DEM_R(8e-6);
    d.threads = 1;
    scene_memory_use(c, &d);
    w = dem_world_create(&d);
    m = scene_material(w, 1e7, 0.3, 0.3, 0);
    for (k = 0; k < 2; k++) {
        const double x = k ? 0 : -0.03, X = k ? 0.03 : 0, p[24] = {x, -0.02, -0.01, X, -0.02, -0.01, X, 0.02, -0.01, x, 0.02,
            -0.01, x, -0.02, 0, X, -0.02, 0, X, 0.02, 0, x, 0.02, 0};
        dem_real v[24];
        int32_t corners[36];
        dem_mesh mesh;
        memcpy(corners, t, sizeof t);
        for (i = 0; i < 24; i++) v[i] = (dem_real)p[i];
        mesh.vertex_count = 8;
        mesh.triangle_count = 12;
        mesh.vertices = v;
        mesh.triangles = corners;
        box = dem_wall_mesh_add(w, m, &mesh);
    }
    rise.kind = DEM_MOTION_TRANSLATING;
    rise.velocity = at(0, 0, 0.2);
    rise.start = 0.003;
    rise.ramp = 0.001;
    CHECK_EQ(dem_wall_motion_set(w, box, &rise), DEM_OK);
    cube = scene_box(w, 0.002, 0.002, 0.002);
    for (i = 0; i < 16; i++) {
        const dem_body b = dem_body_add(w, m, cube, at(-0.026 + 0.0033*i, 0.003*(i%3), 0.001), dem_quat_make(1, 0, 0, 0));
        scene_move(w, b, at(0.5, 0, 0), at(0, 0, 0));
    }
    return w;
}

int main(int argc, char **argv) {
    const int wide = sizeof(dem_real) == sizeof(double);
    test_begin(argc, argv);
    TEST("one slab gives the bits of the world, ledger and wall loads included, for any integrator") {
        int integrator, periodic;
        for (integrator = 0; integrator < 5; integrator++)
            for (periodic = 0; periodic < 2; periodic++) {
                drum_desc d = DRUM;
                dem_world *one, *other;
                dem_slabs *slabs;
                dem_ledger a, b;
                dem_wall_loads c, e;
                dem_wall wall;
                d.integrator = integrator;
                d.periodic = periodic;
                d.threads = 2;
                one = drum(&d);
                other = drum(&d);
                slabs = deal(other, 0, 1);
                CHECK_EQ(scene_step(one, 400), DEM_OK);
                CHECK_EQ(go(slabs, 300), DEM_OK);
                CHECK_EQ(go(slabs, 100), DEM_OK);
                CHECK_EQ(collect(slabs, other), DEM_OK);
                CHECK(dem_counters_get(one).rebuilds > 1);
                a = dem_ledger_get(one);
                b = dem_ledger_get(other);
                CHECK_REL(b.kinetic, a.kinetic, 1e-14);        /* a sum in the world's order */
                CHECK_NEAR(b.residual, a.residual, 1e-14*a.throughput);
                CHECK(a.slide > 0 && a.rolling > 0 && a.walls > 0);
                CHECK(memcmp(&a.elastic, &b.elastic, 9*sizeof(double)) == 0);
                wall.id = 1;
                dem_wall_loads_get(one, wall, &c);
                dem_wall_loads_get(other, wall, &e);
                CHECK(c.contacts > 0 && memcmp(&c, &e, sizeof c) == 0);
                CHECK_EQ(digest(other), digest(one));
                dem_slabs_destroy(slabs);
                dem_world_destroy(one);
                dem_world_destroy(other);
            }
    }
    TEST("a drum in slabs is the drum in one world but for the order of sums") {
        /* sums of about eight forces differ by round-off (of positions: 7e-18 m), which collisions
           then multiply; measured: 0, 9e-19, 7e-18 and 1.5e-15 m */
        static const int after[] = {1, 10, 100, 1000};
        static const double bound[] = {1e-17, 1e-16, 1e-15, 1e-12};
        int periodic, count, k;
        for (periodic = 0; periodic < 2; periodic++)
            for (count = 2; count <= 4; count++) {
                drum_desc d = DRUM;
                dem_world *one, *other;
                dem_slabs *slabs;
                d.periodic = periodic;
                one = drum(&d);
                other = drum(&d);
                slabs = deal(other, 0, count);
                for (k = 0; k < (wide ? 4 : 2); k++) {
                    const int steps = after[k] - (int)dem_world_steps_get(one);
                    dem_ledger a, b;
                    dem_wall_loads c, e;
                    dem_wall wall;
                    CHECK_EQ(scene_step(one, steps), DEM_OK);
                    CHECK_EQ(go(slabs, steps), DEM_OK);
                    CHECK_EQ(collect(slabs, other), DEM_OK);
                    CHECK(whole(slabs, 600));
                    CHECK_NEAR(apart(one, other), 0, wide ? bound[k] : 2e-8);
                    if (getenv("SLABS_NUMBERS"))
                        printf("periodic %d, %d slabs, %d steps: %.2g m apart\n", periodic, count,
                               after[k], apart(one, other));
                    a = dem_ledger_get(one);
                    b = dem_ledger_get(other);
                    CHECK_NEAR(b.elastic, a.elastic, 1e-5*a.elastic);
                    CHECK_REL(b.slide, a.slide, 1e-4);
                    CHECK_NEAR(b.walls, a.walls, 1e-4*fabs(a.walls));
                    CHECK_NEAR(b.residual, a.residual, 1e-4*a.throughput);
                    wall.id = 1;
                    dem_wall_loads_get(one, wall, &c);
                    dem_wall_loads_get(other, wall, &e);
                    CHECK(c.contacts > 50);
                    CHECK_EQ(e.contacts, c.contacts);
                    CHECK_NEAR(e.torque_axial, c.torque_axial, 1e-3*fabs((double)c.torque_axial));
                    CHECK_NEAR(e.impulse[2], c.impulse[2], 1e-4*fabs(c.impulse[2]));
                    CHECK_NEAR(e.work, c.work, 1e-3*fabs(c.work));
                    CHECK_NEAR(e.time, c.time, 1e-12);
                }
                CHECK_REL(dem_slabs_counters_get(slabs).rebuilds, dem_counters_get(one).rebuilds,
                          0.2);                /* one skin, by the same model */
                CHECK_EQ(dem_candidates_rebuild(other), DEM_OK);       /* what was collected goes on */
                CHECK_EQ(scene_step(one, 10), DEM_OK);
                CHECK_EQ(scene_step(other, 10), DEM_OK);
                if (wide) CHECK_NEAR(apart(one, other), 0, 1e-8);
                dem_slabs_destroy(slabs);
                dem_world_destroy(one);
                dem_world_destroy(other);
            }
    }
    TEST("averages of stress, also in wide cells, and the work of a force field are in slabs those of one world") {
        int k;
        for (k = 0; k < 4; k++) {
            drum_desc d = DRUM;
            dem_world *one, *other;
            dem_slabs *slabs;
            dem_field_desc grid;
            dem_field_data a, b;
            dem_field field;
            int i, stressed = 0;
            d.periodic = k & 1;
            d.force = k > 1 ? updraught : 0;
            one = drum(&d);
            other = drum(&d);
            memset(&grid, 0, sizeof grid);
            grid.box = box_of(0, -0.01, -0.01, 0.048, 0.02, 0.02);
            grid.cells[0] = 4; grid.cells[1] = 2; grid.cells[2] = 2;
            grid.interval = 3e-4;
            grid.stress = 1;
            if (k & 2) grid.width = DEM_R(0.008);
            field = dem_field_add(one, &grid);
            dem_field_add(other, &grid);
            CHECK_EQ(scene_step(one, 50), DEM_OK);     /* slabs may take over in mid-run */
            CHECK_EQ(scene_step(other, 50), DEM_OK);
            slabs = deal(other, 0, 3);
            CHECK_EQ(scene_step(one, 150), DEM_OK);
            CHECK_EQ(go(slabs, 150), DEM_OK);
            CHECK_EQ(collect(slabs, other), DEM_OK);
            CHECK_NEAR(apart(one, other), 0, wide ? 1e-12 : 1e-5);
            dem_field_get(one, field, &a);
            dem_field_get(other, field, &b);
            CHECK(a.samples > 5);
            CHECK_EQ(a.samples, b.samples);
            for (i = 0; i < 16 && wide; i++) {
                CHECK_NEAR(b.solid[i], a.solid[i], 1e-9);
                CHECK_NEAR(b.momentum[3*i], a.momentum[3*i], 1e-9*a.mass[i] + 1e-20);
                CHECK_NEAR(b.contacts[i], a.contacts[i], 1e-9*a.grains[i]);
                CHECK_NEAR(b.stress[6*i], a.stress[6*i], 1e-6*fabs(a.stress[6*i]) + 1e-12);
                stressed += a.stress[6*i] > 0;
            }
            CHECK(!wide || stressed > 4);
            if (d.force)
                CHECK_REL(dem_ledger_get(other).force, dem_ledger_get(one).force,
                          wide ? 1e-9 : 1e-2);
            if (test_now.wrong) printf("        case %d\n", k);
            dem_slabs_destroy(slabs);
            dem_world_destroy(one);
            dem_world_destroy(other);
        }
    }
    TEST("a gas of three radii in four slabs loses and doubles no grain in 1e5 steps, and conserves momentum and "
         "energy") {
        int periodic, i;
        for (periodic = 0; periodic < 2; periodic++) {
            dem_world *world = gas(periodic, 1);
            const dem_totals first = dem_totals_get(world);
            dem_slabs *slabs = deal(world, 0, 4);
            const double speed = sqrt(2*first.kinetic/first.mass);
            CHECK_EQ(world->bodies.count, 240);
            for (i = 0; i < 25; i++) {
                dem_totals now;
                CHECK_EQ(go(slabs, 2000), DEM_OK);
                CHECK_EQ(collect(slabs, world), DEM_OK);
                CHECK(whole(slabs, 240));
                now = dem_totals_get(world);
                CHECK_NEAR(now.mass, first.mass, (wide ? 1e-12 : 1e-6)*first.mass);
                if (periodic)                  /* round-off of 5e4 steps */
                    CHECK_NEAR(now.momentum[0], first.momentum[0],
                               (wide ? 1e-11 : 1e-3)*first.mass*speed);
                /* t_c/dt is about 50: elastic energy in contacts, and the integrator's ripple */
                CHECK_NEAR(energy_of(&now), energy_of(&first), 0.05*energy_of(&first));
            }
            CHECK(dem_slabs_counters_get(slabs).migrated > 500);
            dem_slabs_destroy(slabs);
            dem_world_destroy(world);
        }
    }
    TEST("outlets remove in slabs the grains of one world, each once; one slab gives the same bits") {
        int count, k;
        for (count = 1; count <= 4; count++) {
            dem_world *one = bits_world(OUTLETS, 1), *other = bits_world(OUTLETS, 1);
            dem_slabs *slabs = deal(other, 0, count);
            CHECK_EQ(scene_step(one, 2500), DEM_OK);
            CHECK_EQ(go(slabs, 1000), DEM_OK);
            CHECK_EQ(collect(slabs, other), DEM_OK);           /* in passing */
            CHECK_EQ(go(slabs, 1500), DEM_OK);
            CHECK_EQ(collect(slabs, other), DEM_OK);
            for (k = 1; k <= 3; k++) {
                dem_outlet outlet;
                dem_outlet_state a, b;
                outlet.id = k;
                dem_outlet_get(one, outlet, &a);
                dem_outlet_get(other, outlet, &b);
                CHECK(a.total >= 5);
                CHECK_EQ((int)b.total, (int)a.total);
                CHECK_EQ((int)b.count[0], (int)a.count[0]);
                CHECK_EQ((int)b.sorted, (int)a.sorted);
                CHECK_REL(b.total_mass, a.total_mass, 1e-12);
                CHECK(k < 3 || (a.back_total >= 50 && a.held_total >= 2));
                CHECK_EQ((int)b.back_total, (int)a.back_total);
                CHECK_EQ((int)b.held[0], (int)a.held[0]);
                CHECK_NEAR(b.back_total_mass, a.back_total_mass, 1e-12*a.total_mass);
                /* outlets look when a list is made, and every 64 steps */
                CHECK_NEAR(b.last, a.last, count == 1 ? 0 : 64*2e-5);
            }
            CHECK_EQ((int)dem_body_counts_get(other).left, (int)dem_body_counts_get(one).left);
            CHECK_EQ(other->bodies.count, one->bodies.count);
            if (count == 1) CHECK_EQ(digest(other), digest(one));
            else CHECK_NEAR(apart(one, other), 0, 1e-6);
            dem_slabs_destroy(slabs);
            dem_world_destroy(one);
            dem_world_destroy(other);
        }
    }
    TEST("feeds insert in slabs the grains of one world at the same positions, and repeated collection changes "
         "nothing") {
        int ring, count, k;
        for (ring = 0; ring < 2; ring++)
            for (count = 1; count <= 4; count++) {
                dem_world *one = ring ? crate(0, -5, DEM_BOUNDARY_PERIODIC, 200, 0)
                    : crate(-30, -1, DEM_BOUNDARY_OPEN, 200, 0);
                dem_world *other = ring ? crate(0, -5, DEM_BOUNDARY_PERIODIC, 200, 0)
                    : crate(-30, -1, DEM_BOUNDARY_OPEN, 200, 0);
                const dem_feed a = rain(one), b = rain(other);
                dem_feed_state x, y;
                dem_material glass;
                dem_slabs *slabs;
                glass.id = 1;
                for (k = 0; k < 2; k++)         /* of two radii from the first: new ones join the list */
                    CHECK_EQ(dem_spheres_fill(k ? one : other, glass, DEM_R(9e-4),
                                              dem_region_make(box_of(0, 0, 0, 0.06, 0.012, 0.012)), 1, 3), 1);
                CHECK_EQ(scene_step(one, 20), DEM_OK);
                CHECK_EQ(scene_step(other, 20), DEM_OK);
                slabs = deal(other, 0, count);
                for (k = 0; k < 3; k++) {
                    const int steps = 500*(k + 1);
                    CHECK_EQ(scene_step(one, steps), DEM_OK);
                    CHECK_EQ(go(slabs, steps), DEM_OK);
                    CHECK_EQ(collect(slabs, other), DEM_OK);
                    CHECK_EQ(dem_feed_get(one, a, &x), DEM_OK);
                    CHECK_EQ(dem_feed_get(other, b, &y), DEM_OK);
                    CHECK(x.total > 3);
                    CHECK_EQ((int)y.total, (int)x.total);
                    CHECK_EQ((int)y.fed[0], (int)x.fed[0]);
                    CHECK_EQ((int)y.waiting, (int)x.waiting);
                    CHECK(whole(slabs, one->bodies.count));
                    CHECK_EQ((int)dem_body_counts_get(other).inserted,
                             (int)dem_body_counts_get(one).inserted);
                    CHECK_EQ((int)dem_body_counts_get(other).present,
                             (int)dem_body_counts_get(one).present);
                    CHECK_NEAR(apart(one, other), 0, wide ? 1e-7 : 1e-3);
                    CHECK_NEAR(dem_ledger_get(other).inserted, dem_ledger_get(one).inserted,
                               1e-9*dem_ledger_get(one).throughput);
                }
                CHECK_EQ(scene_step(other, 300), DEM_OK);
                CHECK_EQ(scene_step(one, 300), DEM_OK);
                CHECK_EQ(other->bodies.count, one->bodies.count);
                /* what came into the world since is not the slabs' */
                CHECK(dem_sphere_add(other, glass, DEM_R(5e-4), at(0.02, 0.005, 0.05)).slot > 0);
                CHECK_EQ(dem_slabs_collect(slabs, other), DEM_ERROR_ARGUMENT);
                CHECK_STR(dem_slabs_error_get(slabs), "added to the world after");
                dem_slabs_destroy(slabs);
                dem_world_destroy(one);
                dem_world_destroy(other);
            }
    }
    TEST("ellipsoids, clusters, a shaking sieve and fields keep their bits in one slab") {
        int scene;
        for (scene = SHAPES; scene <= SIEVE; scene++) {
            dem_world *one = bits_world(scene, 1), *other = bits_world(scene, 1);
            dem_slabs *slabs = deal(other, 0, 1);
            dem_field_data a, b;
            dem_field field;
            dem_ledger x, y;
            field.id = 1;
            CHECK_EQ(scene_step(one, 1500), DEM_OK);
            CHECK_EQ(go(slabs, 1500), DEM_OK);
            CHECK_EQ(collect(slabs, other), DEM_OK);
            CHECK(whole(slabs, one->bodies.count));
            x = dem_ledger_get(one);
            y = dem_ledger_get(other);
            CHECK_REL(y.slide, x.slide, 1e-4);
            CHECK_NEAR(y.residual, x.residual, 1e-4*x.throughput);
            dem_field_get(one, field, &a);
            dem_field_get(other, field, &b);
            CHECK(!wide || a.samples > 3);
            CHECK_EQ((int)b.samples, (int)a.samples);
            CHECK_REL(b.mass[1], a.mass[1], 1e-6);
            CHECK_EQ(digest(other), digest(one));
            dem_slabs_destroy(slabs);
            dem_world_destroy(one);
            dem_world_destroy(other);
        }
    }
    TEST("a number of slabs gives the same bits on one, two, three and four threads") {
        int scene, threads;
        for (scene = 0; scene < BITS; scene++) {
            const int steps = scene < SHAPES ? 2000 : 1200;
            const uint64_t one = bits_of(scene, 1, 4, steps);
            for (threads = 2; threads <= 4; threads++)
                CHECK_EQ(bits_of(scene, threads, 4, steps), one);
            if (scene != GAS) CHECK(bits_of(scene, 1, 3, steps) != one);   /* the order is seen */
        }
    }
#if DEMI_OPENMP
    TEST("slabs in three processes give the bits of the same slabs in one") {
        int scene, count, ranks = 0;
        for (scene = 0; scene < BITS; scene++)
            for (count = scene < SHAPES ? 3 : 5; count <= 5; count++) {
                const uint64_t here = bits_of(scene, 1, count, 2000);
                const uint64_t there = ring_bits(scene, count, 2000, &ranks);
                if (ranks == RANKS) CHECK_EQ(there, here);
            }
    }
#endif
    TEST("a sheared pair that crosses a border keeps its spring and its force") {
        /* the two are pressed together, run along x at 1 m/s and twist against each other; so does
           one on a plane: its contact with the wall migrates too */
        int k, steps, border;
        for (border = 0; border < 2; border++) {
            dem_world *world[2];
            dem_slabs *slabs;
            double held = 0;
            int crossed = 0;
            for (k = 0; k < 2; k++) {
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_material glass;
                const dem_real x[12] = {DEM_R(0.01), DEM_R(-0.00099), 0,
                                        DEM_R(0.0101), DEM_R(0.00099), 0,
                                        DEM_R(0.01), 0, DEM_R(-0.0209),
                                        DEM_R(0.04), 0, 0};
                dem_body_state s;
                int i;
                desc.dt = DEM_R(1e-5);
                desc.threads = 1;
                desc.impact_speed = 1;
                desc.force = squeeze;
                if (border) {
                    desc.boundary[0] = DEM_BOUNDARY_PERIODIC;
                    desc.domain = box_of(0, -1, -1, 0.05, 1, 1);
                }
                world[k] = dem_world_create(&desc);
                glass = scene_material(world[k], 1e6, 0.5, 0.8, 0);
                scene_plate(world[k], glass);
                dem_spheres_add(world[k], glass, 4, x, 0, 0, DEM_R(1e-3));
                for (i = 0; i < 3; i++)
                    scene_move(world[k], dem_body_id_get(world[k], i), at(1, 0, 0),
                               at(i == 1 ? 3 : 0, 0, i == 0 ? 2 : 0));
                s = scene_state(world[k], dem_body_id_get(world[k], 3));
                s.fixed = 1;
                dem_body_set(world[k], dem_body_id_get(world[k], 3), &s);
            }
            slabs = deal(world[1], 0, 2);
            for (steps = 0; steps < 4000; steps += 50) {
                dem_contact_info info[2][8];
                int n[2], i, j;
                CHECK_EQ(scene_step(world[0], 50), DEM_OK);
                CHECK_EQ(go(slabs, 50), DEM_OK);
                CHECK_EQ(collect(slabs, world[1]), DEM_OK);
                CHECK_NEAR(apart(world[0], world[1]), 0, wide ? 1e-12 : 1e-5);
                for (k = 0; k < 2; k++) {      /* a search does not touch memory */
                    dem_candidates_rebuild(world[k]);
                    n[k] = dem_contacts_get(world[k], info[k], 8);
                }
                CHECK_EQ(n[1], n[0]);
                for (i = 0; i < n[0] && i < 8; i++)
                    for (j = 0; j < n[1] && j < 8; j++) {
                        const dem_contact_info *p = &info[0][i], *q = &info[1][j];
                        const int same = p->a.slot == q->a.slot && p->b.slot == q->b.slot;
                        if (!same || p->wall) continue;
                        CHECK_NEAR(q->force.x, p->force.x, wide ? 1e-10 : 1e-4);
                        CHECK_NEAR(q->force.z, p->force.z, wide ? 1e-10 : 1e-4);
                        held = DEMI_MAX(held, fabs((double)p->force.z));
                    }
                CHECK_EQ(digest(world[1]) != 0, 1);
                crossed = (int)dem_slabs_counters_get(slabs).migrated;
            }
            CHECK(held > 1e-5);                /* N: there was something to lose */
            CHECK(crossed >= 3);
            dem_slabs_destroy(slabs);
            for (k = 0; k < 2; k++) dem_world_destroy(world[k]);
        }
    }
    TEST("borders follow a heap that runs to one side, and balance its load") {
        int still;
        double worst[2] = {0, 0};
        for (still = 0; still < 2; still++) {
            dem_world *world = crate(-30, 0, DEM_BOUNDARY_OPEN, 300, 0);
            dem_slabs_desc desc = DEM_SLABS_DESC;
            dem_slabs *slabs;
            dem_slab first, now;
            double most = 0, total = 0;
            int k;
            desc.count = 3;
            desc.balance = DEM_R(still ? -1 : 0);
            slabs = dem_slabs_create(world, &desc);
            dem_slab_get(slabs, 1, &first);
            CHECK_EQ(go(slabs, 12000), DEM_OK);
            CHECK(whole(slabs, 300));
            for (k = 0; k < 3; k++) {
                dem_slab_get(slabs, k, &now);
                total += now.work;
                most = DEMI_MAX(most, now.work);
                if (k != 1) continue;
                if (still) CHECK_NEAR(now.lo, first.lo, 1e-15);
                else CHECK(now.lo < 0.8*first.lo);
                CHECK(now.hi - now.lo > 2e-3);         /* never thinner than two grains */
            }
            worst[still] = 3*most/total;
            CHECK_EQ(dem_slabs_counters_get(slabs).border_moves > 0, !still);
            dem_slabs_destroy(slabs);
            dem_world_destroy(world);
        }
        if (getenv("SLABS_NUMBERS"))
            printf("work, most over mean: %.3f, %.3f\n", worst[0], worst[1]);
        CHECK(worst[0] < 1.3);
        CHECK(worst[1] > 1.6);
    }
    TEST("grains that leave through an outflow boundary leave once, in slabs as in one world") {
        dem_world *one = crate(-10, -2, DEM_BOUNDARY_OUTFLOW, 200, 0);
        dem_world *other = crate(-10, -2, DEM_BOUNDARY_OUTFLOW, 200, 0);
        dem_slabs *slabs = deal(other, 0, 3);
        int k;
        for (k = 0; k < 6; k++) {
            dem_body_counts a, b;
            CHECK_EQ(scene_step(one, 500), DEM_OK);
            CHECK_EQ(go(slabs, 500), DEM_OK);
            CHECK_EQ(collect(slabs, other), DEM_OK);
            a = dem_body_counts_get(one);
            b = dem_body_counts_get(other);
            CHECK_EQ(b.left, a.left);
            CHECK_EQ(b.present, a.present);
            CHECK_EQ(b.inserted, b.present + b.removed + b.left);
            CHECK_EQ(dem_bodies_get(other).count, b.present);
            CHECK_REL(dem_ledger_get(other).removed, dem_ledger_get(one).removed, 1e-3);
        }
        CHECK(dem_body_counts_get(one).left > 20);
        CHECK(dem_body_counts_get(one).left < 200);
        dem_slabs_destroy(slabs);
        dem_world_destroy(one);
        dem_world_destroy(other);
    }
    TEST("a time step that the library chooses is the same in slabs") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world[2];
        dem_slabs *slabs;
        dem_real first;
        int k;
        for (k = 0; k < 2; k++) {
            dem_material glass;
            desc.gravity = at(0, 0, -9.81);
            desc.threads = 1;
            world[k] = dem_world_create(&desc);
            glass = scene_material(world[k], 1e6, 0.9, 0.3, 0);
            dem_wall_plane_add(world[k], glass, at(0, 0, 0), at(0, 0, 1));
            scene_block(world[k], glass, 16, 3, 3, 1e-3, 1, 0.1, 3);
        }
        slabs = deal(world[1], 0, 3);
        CHECK_EQ(scene_step(world[0], 1), DEM_OK);
        CHECK_EQ(go(slabs, 1), DEM_OK);
        first = dem_slabs_counters_get(slabs).dt;
        CHECK_REL(first, dem_counters_get(world[0]).dt, wide ? 1e-14 : 1e-6);
        scene_step(world[0], 50);
        CHECK_EQ(go(slabs, 50), DEM_OK);
        CHECK_EQ(collect(slabs, world[1]), DEM_OK);
        dem_slabs_destroy(slabs);
        for (k = 0; k < 2; k++)                /* from now on one is much faster */
            scene_move(world[k], dem_body_id_get(world[k], world[k]->bodies.slot_index[5]), at(0, 0, 4),
                       at(0, 0, 0));
        slabs = deal(world[1], 0, 3);
        scene_step(world[0], 50);
        CHECK_EQ(go(slabs, 50), DEM_OK);
        CHECK_REL(dem_slabs_counters_get(slabs).dt, dem_counters_get(world[0]).dt,
                  wide ? 1e-6 : 1e-3);
        CHECK((double)dem_slabs_counters_get(slabs).dt < 0.8*(double)first);
        dem_slabs_destroy(slabs);
        for (k = 0; k < 2; k++) dem_world_destroy(world[k]);
    }
    TEST("without grains time passes and walls move in slabs as in one world, and a time step that is set holds") {
        int k, count;
        for (count = 1; count < 4; count += 2)
            for (k = 0; k < 4; k++) {           /* dt chosen or given; from the start or set later */
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_world *world[2];
                dem_slabs *slabs;
                int i;
                desc.dt = k & 1 ? DEM_R(2e-5) : 0;
                for (i = 0; i < 2; i++) {
                    dem_material glass;
                    dem_motion move = DEM_MOTION;
                    dem_wall floor;
                    world[i] = dem_world_create(&desc);
                    glass = scene_material(world[i], 1e6, 0.9, 0.3, 0);
                    floor = dem_wall_plane_add(world[i], glass, at(0, 0, 0), at(0, 0, 1));
                    move.kind = DEM_MOTION_TRANSLATING;
                    move.velocity = at(0, 0, 0.1);
                    CHECK_EQ(dem_wall_motion_set(world[i], floor, &move), DEM_OK);
                    if (k < 2) continue;
                    CHECK_EQ(scene_step(world[i], 3), DEM_OK);
                    CHECK_EQ(dem_world_dt_set(world[i], DEM_R(3e-5)), DEM_OK);
                }
                slabs = deal(world[1], 0, count);
                CHECK_EQ(go(slabs, 10), DEM_OK);
                CHECK_EQ(scene_step(world[0], 10), DEM_OK);
                CHECK_REL(dem_world_desc_get(world[0]).dt, k > 1 ? 3e-5 : k ? 2e-5 : 1e-3, 1e-6);
                CHECK_EQ(collect(slabs, world[1]), DEM_OK);
                CHECK_EQ(dem_world_hash_get(world[1]), dem_world_hash_get(world[0]));
                CHECK(dem_world_time_get(world[1]) > 1e-4);
                dem_slabs_destroy(slabs);
                for (i = 0; i < 2; i++) dem_world_destroy(world[i]);
            }
    }
    TEST("a time step and a gravity set in mid-run hold in slabs and in the collected world") {
        int count;
        for (count = 1; count < 4; count += 2) {
            dem_world *world[3];                /* stepped, dealt, collected into */
            dem_slabs *slabs;
            int k;
            for (k = 0; k < 3; k++) {
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_material glass;
                desc.threads = 1;
                desc.dt = DEM_R(1e-5);
                world[k] = dem_world_create(&desc);
                glass = scene_material(world[k], 1e6, 0.9, 0.3, 0);
                dem_wall_plane_add(world[k], glass, at(0, 0, 0), at(0, 0, 1));
                scene_block(world[k], glass, 16, 3, 3, 1e-3, 1, 0.1, 3);
                scene_step(world[k], 5);
                if (k == 2) continue;
                CHECK_EQ(dem_world_dt_set(world[k], DEM_R(4e-6)), DEM_OK);
                CHECK_EQ(dem_world_gravity_set(world[k], at(1, 0, -9.81)), DEM_OK);
            }
            slabs = deal(world[1], 0, count);
            CHECK_EQ(go(slabs, 40), DEM_OK);
            CHECK_EQ(scene_step(world[0], 40), DEM_OK);
            CHECK_REL(dem_slabs_counters_get(slabs).dt, 4e-6, wide ? 1e-15 : 1e-7);
            for (k = 1; k < 3; k++) {
                CHECK_EQ(collect(slabs, world[k]), DEM_OK);
                if (count == 1) CHECK_EQ(dem_world_hash_get(world[k]), dem_world_hash_get(world[0]));
            }
            for (k = 0; k < 3; k++) CHECK_EQ(scene_step(world[k], 40), DEM_OK);
            CHECK_EQ(dem_world_hash_get(world[1]), dem_world_hash_get(world[2]));
            CHECK_REL(dem_world_time_get(world[2]), dem_world_time_get(world[0]), 1e-14);     /* rounding of sums */
            dem_slabs_destroy(slabs);
            for (k = 0; k < 3; k++) dem_world_destroy(world[k]);
        }
    }
    TEST("one slab continues with the bits of the world, whichever desc field changes") {
        const walk_fields *all = walk_all();
        int k, kind, way, runs = 0;
        for (k = 0; k < all->count; k++)
            for (kind = 0; kind < WALK_IMPULSES; kind++)
                for (way = 0; way < 6; way++) {
                    walk_scene s = walk_begin(kind);
                    dem_world *world[2];
                    dem_slabs *slabs;
                    dem_result there, here;
                    int i;
                    s.feed.start = 1;            /* newcomers join lists in another order */
                    if (!walk_change(&all->field[k], &s, way)) break;
                    for (i = 0; i < 2; i++) world[i] = walk_make(&s, 0);
                    if (!world[0] || !world[1]) {
                        for (i = 0; i < 2; i++) dem_world_destroy(world[i]);
                        continue;
                    }
                    if (dem_world_step(world[0], 3) == DEM_OK) {
                        dem_world_step(world[1], 3);
                        slabs = deal(world[1], 0, 1);
                        if (!slabs && s.field.variance) {    /* refused: a cell may lie in two slabs */
                            CHECK_STR(dem_world_error_get(world[1]), "has variance");
                            for (i = 0; i < 2; i++) dem_world_destroy(world[i]);
                            continue;
                        }
                        there = dem_slabs_step(slabs, 40);
                        here = dem_world_step(world[0], 40);
                        CHECK_EQ(there, here);
                        if (here == DEM_OK) {
                            const int before = test_now.wrong;
                            CHECK_EQ(collect(slabs, world[1]), DEM_OK);
                            CHECK_EQ(dem_world_hash_get(world[1]), dem_world_hash_get(world[0]));
                            if (test_now.wrong > before) printf("        %s in scene %d\n", all->field[k].name, kind);
                            runs++;
                        }
                        dem_slabs_destroy(slabs);
                    }
                    for (i = 0; i < 2; i++) dem_world_destroy(world[i]);
                    kind = WALKS;                /* one scene that accepts it */
                    break;
                }
        CHECK(runs > 250);
    }
    TEST("a step too large for pressed contacts is rejected in slabs with the limit of one world, and dt = 0 shortens "
         "it") {
        int count, chosen;
        for (count = 1; count <= 3; count++)
            for (chosen = 0; chosen < 2; chosen++) {
                dem_world *world = crystal(chosen ? 0 : 1e-5, 0, 0), *twin = crystal(chosen ? 0 : 1e-5, 0, 0);
                dem_slabs *slabs = deal(twin, 0, count);
                const dem_result expected = chosen ? DEM_OK : DEM_ERROR_TIME_STEP;
                const char *limit;
                CHECK_EQ(dem_world_step(world, 1), expected);
                CHECK_EQ(dem_slabs_step(slabs, 1), expected);
                if (chosen) {
                    dem_advice advice;
                    CHECK_EQ(dem_step_advice_get(world, &advice), DEM_OK);
                    CHECK(world->clock.dt < DEM_R(0.9)*advice.dt);      /* what presses binds */
                    CHECK_REL(slabs->head.clock.dt, world->clock.dt, 1e-9);
                    CHECK_EQ(go(slabs, 100), DEM_OK);
                } else {
                    limit = strstr(dem_world_error_get(world), "must be at most");
                    CHECK(limit && strstr(limit, "is pressed by 12 contacts"));
                    CHECK_STR(dem_slabs_error_get(slabs), "is pressed by 12 contacts");
                    CHECK(limit && !strncmp(limit, strstr(dem_slabs_error_get(slabs), "must be at most"), 24));
                }
                dem_slabs_destroy(slabs);
                dem_world_destroy(world);
                dem_world_destroy(twin);
            }
    }
    TEST("a grain that would pass others within one step stops slabs with its name, at the start and in mid-run") {
        int count;
        for (count = 1; count <= 3; count++) {
            dem_world *world = crystal(1e-7, 2e4, 0);
            dem_slabs *slabs = deal(world, 0, count);
            CHECK_EQ(dem_slabs_step(slabs, 1), DEM_ERROR_TIME_STEP);
            CHECK_STR(dem_slabs_error_get(slabs), "radii of the smallest grain");
            CHECK_NEAR(slabs->head.clock.time, 0, 0);
            dem_slabs_destroy(slabs);
            dem_world_destroy(world);
            world = crystal(1e-7, 0, 1e9);
            slabs = deal(world, 0, count);
            CHECK_EQ(dem_slabs_step(slabs, 1000), DEM_ERROR_TIME_STEP);
            CHECK_STR(dem_slabs_error_get(slabs), "radii of the smallest grain");
            CHECK(slabs->head.clock.time > 0);
            dem_slabs_destroy(slabs);
            dem_world_destroy(world);
        }
    }
    TEST("an allocation that fails at any moment is named, and the run continues with the same bits") {
        /* a heap of spheres; bodies of all shapes, at every fifth request */
        int shapes;
        for (shapes = 0; shapes < 2; shapes++) {
            const int steps = shapes ? 900 : 1500;
            scene_memory c;
            uint64_t end = 0;
            long k, calls = 0;
            int tries;
            for (k = 0; k == 0 || (k <= calls && test_now.wrong == 0); k += k && shapes ? 5 : 1) {
                dem_world *world = shapes ? mixture(ON_FLOOR, DEM_BOUNDARY_OPEN, 1, 30, &c)
                    : crate(-30, -2, DEM_BOUNDARY_OPEN, 90, &c);
                dem_slabs_desc desc = DEM_SLABS_DESC;
                dem_slabs *slabs = 0;
                dem_result result = DEM_OK;
                const long before = c.calls;
                uint64_t hash;
                desc.count = 3;
                desc.balance_interval = 1;
                c.refuse = k ? before + k : 0;
                for (tries = 0; !slabs && tries < 3; tries++) {
                    const uint64_t was = dem_world_hash_get(world);
                    slabs = dem_slabs_create(world, &desc);
                    if (slabs) break;
                    CHECK_STR(dem_world_error_get(world), "dem_slabs_create: out of memory");
                    CHECK_EQ(dem_world_hash_get(world), was);
                }
                for (tries = 0; tries < 3; tries++) {
                    const int left = steps - (int)dem_slabs_counters_get(slabs).steps;
                    result = dem_slabs_step(slabs, left);
                    if (result == DEM_OK) break;
                    CHECK_EQ(result, DEM_ERROR_MEMORY);
                    CHECK_STR(dem_slabs_error_get(slabs), "out of memory");
                    CHECK_STR(dem_slabs_error_get(slabs), "dem_slabs_step: slab");
                    CHECK_EQ(dem_slabs_collect(slabs, world), DEM_OK);     /* nothing was lost */
                    CHECK_EQ(dem_bodies_get(world).count, 90);
                }
                CHECK_EQ(result, DEM_OK);
                CHECK(whole(slabs, 90));
                for (tries = 0; tries < 3; tries++) {
                    const uint64_t was = dem_world_hash_get(world);     /* contact histories included */
                    if ((result = dem_slabs_collect(slabs, world)) == DEM_OK) break;
                    CHECK_EQ(dem_world_hash_get(world), was);
                }
                CHECK_EQ(result, DEM_OK);
                if (k == 0) calls = c.calls - before;
                c.refuse = 0;
                hash = digest(world);
                if (k == 0) end = hash;
                CHECK_EQ(hash, end);
                CHECK(k == 0 || c.refused || k > c.calls - before);
                dem_slabs_destroy(slabs);
                dem_world_destroy(world);
                CHECK_EQ(c.blocks, 0);
                if (test_now.wrong) printf("        at request %ld of %ld\n", k, calls);
            }
            CHECK(calls > 100);
        }
    }
    TEST("a gate that begins to move splits a floor in slabs as in one world, also if memory runs out in that step") {
        long k, calls = 1;
        for (k = 0; k <= calls && test_now.wrong == 0; k++) {
            scene_memory c, one;
            dem_world *world[2];
            dem_slabs *slabs;
            int i, n;
            long before;
            for (i = 0; i < 2; i++) world[i] = gate(i ? &c : &one);
            slabs = deal(world[1], 0, 3);
            for (i = 0; i < 2; i++) CHECK_EQ(i ? go(slabs, 370) : scene_step(world[0], 370), DEM_OK);
            for (i = 0; i < 3; i++) CHECK_EQ(slabs->slabs[i].world->surface_count, 1);
            before = c.calls;
            c.refuse = k ? before + k : 0;
            CHECK_EQ(scene_step(world[0], 20), DEM_OK);
            for (i = 0; i < 100 && (dem_slabs_counters_get(slabs).steps < 390 || slabs->head.stage.moved); i++)
                if (dem_slabs_step(slabs, 1) != DEM_OK) CHECK_STR(dem_slabs_error_get(slabs), "out of memory");
            if (!k) calls = c.calls - before;
            for (i = 0; i < 3; i++) CHECK_EQ(slabs->slabs[i].world->surface_count, 0);
            CHECK_EQ(world[0]->surface_count, 0);
            CHECK_EQ(go(slabs, 490), DEM_OK);
            CHECK_EQ(scene_step(world[0], 490), DEM_OK);
            CHECK_EQ(collect(slabs, world[1]), DEM_OK);
            for (n = 1; n <= dem_bodies_get(world[0]).count; n++) {
                const dem_body b = dem_body_id_get(world[0], n - 1);
                CHECK_NEAR((double)demi_length(demi_sub(scene_state(world[0], b).position,
                           scene_state(world[1], b).position)), 0, sizeof(dem_real) == 8 ? 1e-12 : 1e-6);
            }
            for (i = 0; i < 2; i++) CHECK_EQ(scene_step(world[i], 1), DEM_OK);
            CHECK_EQ(world[1]->surface_count, 0);
            dem_slabs_destroy(slabs);
            for (i = 0; i < 2; i++) dem_world_destroy(world[i]);
            CHECK_EQ(c.blocks, 0);
        }
        CHECK(calls > 20);
    }
    TEST("a collection that runs out of memory leaves the recording of contacts of the world as it was") {
        scene_memory c;
        dem_world *world = crate(-30, -2, DEM_BOUNDARY_OPEN, 90, &c);
        dem_events_desc record = DEM_EVENTS_DESC;
        dem_result result = DEM_ERROR_MEMORY;
        dem_slabs *slabs;
        dem_impacts was, now;
        dem_material all;
        uint64_t hash;
        double time;
        long k;
        all.id = 0;
        CHECK_EQ(dem_events_record(world, &record), DEM_OK);
        CHECK_EQ(scene_step(world, 500), DEM_OK);
        slabs = deal(world, 0, 2);
        CHECK_EQ(go(slabs, 1000), DEM_OK);
        CHECK_EQ(dem_impacts_get(world, all, all, &was), DEM_OK);
        CHECK(was.ended > 0);
        hash = dem_world_hash_get(world);
        time = dem_world_time_get(world);
        for (k = 1; k < 400 && result != DEM_OK; k++) {
            c.refuse = c.calls + k;
            result = dem_slabs_collect(slabs, world);
            c.refuse = 0;
            if (result == DEM_OK) break;
            CHECK_EQ(result, DEM_ERROR_MEMORY);
            CHECK_EQ(dem_impacts_get(world, all, all, &now), DEM_OK);
            CHECK_NEAR(now.ended, was.ended, 0);
            CHECK_NEAR(now.seconds, was.seconds, 0);
            CHECK_EQ(now.open, was.open);
            CHECK_NEAR(dem_world_time_get(world), time, 0);
            CHECK_EQ(dem_world_hash_get(world), hash);
        }
        CHECK(k > 3);
        CHECK_EQ(dem_impacts_get(world, all, all, &now), DEM_OK);
        CHECK(now.ended > was.ended && now.seconds > was.seconds);
        dem_slabs_destroy(slabs);
        dem_world_destroy(world);
        CHECK_EQ(c.blocks, 0);
        CHECK_EQ(c.wrong, 0);
    }
    TEST("slabs that are dealt between a change of laws and the next step do what one world does") {
        int change, count;
        for (change = 0; change < LAW_CHANGES; change++)
            for (count = 1; count < 4; count += 2) {
                dem_world *world[2];           /* stepped, dealt */
                dem_slabs *slabs;
                const int before = test_now.wrong;
                int k;
                for (k = 0; k < 2; k++) world[k] = bed_changed(change);
                slabs = deal(world[1], 0, count);
                CHECK_EQ(scene_step(world[0], 20), DEM_OK);
                CHECK_EQ(go(slabs, 20), DEM_OK);
                CHECK_EQ(collect(slabs, world[1]), DEM_OK);
                if (count == 1) CHECK_EQ(dem_world_hash_get(world[1]), dem_world_hash_get(world[0]));
                CHECK_NEAR(spin_apart(world[0], world[1]), 0, wide ? 1e-9 : 1e-2);
                if (test_now.wrong > before) printf("        change %d, %d slabs\n", change, count);
                dem_slabs_destroy(slabs);
                for (k = 0; k < 2; k++) dem_world_destroy(world[k]);
            }
    }
    TEST("loads can be reset, and impossible calls fail with an error") {
        drum_desc d = DRUM;
        dem_world *world = drum(&d), *small = gas(1, 1), *flat;
        dem_slabs_desc desc = DEM_SLABS_DESC;
        dem_world_desc planar = DEM_WORLD_DESC;
        dem_slabs *slabs;
        dem_wall_loads c;
        dem_slab slab;
        dem_material first;
        dem_wall wall;
        CHECK(!dem_slabs_create(world, &desc));
        CHECK_STR(dem_world_error_get(world), "count is 0, must be 1 to 1024");
        desc.count = 2;
        desc.axis = 3;
        CHECK(!dem_slabs_create(world, &desc));
        CHECK_STR(dem_world_error_get(world), "axis is 3, must be 0, 1 or 2");
        desc.axis = 0;
        desc.first = 1; desc.local = 2;
        CHECK(!dem_slabs_create(world, &desc));
        CHECK_STR(dem_world_error_get(world), "slabs 1 to 2, must lie in 0 to 1");
        desc.local = 1;
        CHECK(!dem_slabs_create(world, &desc));
        CHECK_STR(dem_world_error_get(world), "this process holds 1 of 2 slabs, but the transport lacks");
        desc.first = desc.local = 0;
        desc.balance = DEM_R(0.5);
        CHECK(!dem_slabs_create(world, &desc));
        CHECK_STR(dem_world_error_get(world), "balance is 0.5");
        planar.planar = 1;
        flat = dem_world_create(&planar);
        desc.balance = 0;
        desc.axis = 2;
        CHECK(!dem_slabs_create(flat, &desc));
        CHECK_STR(dem_world_error_get(flat), "for discs, at z = 0");
        desc.axis = 0;
        CHECK_STR(dem_slabs_error_get(0), "dem_slabs_create: returned null");
        slabs = deal(world, 0, 3);
        CHECK_EQ(go(slabs, 20), DEM_OK);
        dem_slabs_loads_reset(slabs);
        CHECK_EQ(go(slabs, 10), DEM_OK);
        CHECK_EQ(collect(slabs, world), DEM_OK);
        wall.id = 1;
        dem_wall_loads_get(world, wall, &c);
        CHECK_NEAR(c.time, 1e-4, 1e-9);
        CHECK_EQ(dem_slab_get(slabs, 3, &slab), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_slabs_error_get(slabs), "slab 3 is not here, this process holds slabs 0 to 2 of 3");
        CHECK_EQ(dem_slabs_step(slabs, -1), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_slabs_error_get(slabs), "steps is -1, must be >= 0");
        CHECK_EQ(dem_slabs_collect(slabs, small), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_slabs_error_get(slabs), "collect into the world from which they were created");
        dem_body_remove(world, dem_body_id_get(world, 3));
        CHECK_EQ(dem_slabs_collect(slabs, world), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_slabs_error_get(slabs), "no longer in the world; collect before removing");
        first.id = 1;
        CHECK_EQ(dem_candidates_rebuild(world), DEM_OK);                /* from now on its slot is free */
        dem_sphere_add(world, first, DEM_R(1e-3), at(0, 0, 0.5));   /* takes the removed one's slot */
        CHECK_EQ(dem_slabs_collect(slabs, world), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_slabs_error_get(slabs), "was added to the world after the slabs were created");
        dem_slabs_destroy(slabs);
        slabs = deal(small, 0, 16);            /* 50 mm in 16 slabs: 3.1 mm, largest grain 3 mm */
        CHECK_EQ(dem_slabs_step(slabs, 1), DEM_OK);
        dem_slabs_destroy(slabs);
        slabs = deal(small, 0, 17);
        CHECK_EQ(dem_slabs_step(slabs, 1), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_slabs_error_get(slabs), "use at most 16 slabs or a smaller skin");
        dem_slabs_destroy(slabs);
        slabs = deal(flat, 1, 3);              /* discs in a plane, none of them: nothing to do */
        CHECK_EQ(go(slabs, 5), DEM_OK);
        CHECK_EQ(collect(slabs, flat), DEM_OK);
        CHECK_EQ(dem_world_steps_get(flat), 5);
        dem_slabs_destroy(slabs);
        dem_world_destroy(world);
        dem_world_destroy(small);
        dem_world_destroy(flat);
    }
    TEST("slabs are not collected into a world one of whose walls was removed or replaced since") {
        drum_desc d = DRUM;
        int k;
        for (k = 0; k < 2; k++) {
            dem_world *world = drum(&d);
            dem_slabs *slabs;
            dem_wall wall;
            wall.id = 1;
            slabs = deal(world, 0, 2);
            CHECK_EQ(go(slabs, 10), DEM_OK);
            CHECK_EQ(dem_wall_remove(world, wall), DEM_OK);
            if (k) {
                dem_material m;
                m.id = 1;
                wall = dem_wall_plane_add(world, m, at(0, 0, -1), at(0, 0, 1));
            }
            CHECK_EQ(dem_slabs_collect(slabs, world), DEM_ERROR_ARGUMENT);
            CHECK_STR(dem_slabs_error_get(slabs), k ? "was added to the world after" : "wall 1 was removed from the world after");
            if (k) {
                dem_pose pose;
                CHECK_EQ(dem_wall_pose_get(world, wall, &pose), DEM_OK);
                CHECK_NEAR(pose.position.z, -1, 0);
            }
            dem_slabs_destroy(slabs);
            dem_world_destroy(world);
        }
    }
    TEST("an overlap above one radius stops the run with the number of the slab that found it") {
        dem_world *world = crate(0, 0, DEM_BOUNDARY_OPEN, 60, 0);
        dem_slabs *slabs;
        dem_body_state s;
        int i, one = 0;
        for (i = 1; i < 60; i++)
            if (world->bodies.pos[4*i] > world->bodies.pos[4*one]) one = i;
        s = scene_state(world, dem_body_id_get(world, one));
        s.velocity.x = 45;                    /* nearly a radius a step */
        dem_body_set(world, dem_body_id_get(world, one), &s);
        slabs = deal(world, 0, 3);
        CHECK_EQ(dem_slabs_step(slabs, 20), DEM_ERROR_UNSTABLE);
        CHECK_STR(dem_slabs_error_get(slabs), "dem_slabs_step: slab 2: ");
        CHECK_STR(dem_slabs_error_get(slabs), "overlap");
        dem_slabs_destroy(slabs);
        dem_world_destroy(world);
    }
    return test_end();
}
