/* Checkpoints: run(2N) = run(N) + checkpoint + run(N) bit for bit, hash, ledger, fields and
   loads; and files that must be refused by name, with the world as it was. Files go to
   build/tmp/. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"
#include "../walk.h"

static const char path[] = "build/tmp/state.ckpt";
enum { LAW_SPRING, LAW_MINDLIN, LAW_EPSD };

static dem_vec3 swirl(dem_vec3 x, dem_vec3 v, dem_real radius, dem_real mass, double time,
                      void *user) {
    const double s = 20*(double)mass*cos(300*time);
    (void)radius; (void)user;
    return at(s - (double)v.x*1e-6, -s*(double)x.x*100, 0);
}

static void stand_still(double time, dem_pose *pose, void *user) { (void)time; (void)pose; (void)user; }

typedef struct play {
    dem_integrator integrator;
    /* late: grains come and go in the second half too */
    int law, steps, nx, ny, nz, threads, late;
    double dt;                                   /* 0: chosen */
} play;
static play play_make(int integrator, int law) {
    play p = {DEM_INTEGRATOR_VELOCITY_VERLET, 0, 60, 4, 4, 3, 1, 1, 5e-6};
    p.integrator = (dem_integrator)integrator;
    p.law = law;
    return p;
}

static dem_world *play_world(const play *p) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material glass;
    dem_motion motion = DEM_MOTION;
    dem_field_desc field;
    dem_wall wall;
    const double middle = 1.97e-3*p->nx/2, radius = sqrt(2.0)*1.97e-3*(p->nx - 1)/2 + 1.05e-3;
    int k;
    desc.threads = p->threads;
    desc.integrator = p->integrator;
    desc.gravity = at(0, 0, -500);              /* keeps the heap together in a short time */
    desc.tangent_law = p->law == LAW_MINDLIN ? DEM_TANGENT_MINDLIN : DEM_TANGENT_SPRING;
    if (p->law == LAW_EPSD) desc.rolling_law = DEM_ROLLING_EPSD;
    desc.dt = (dem_real)p->dt;
    desc.allow_large_dt = 1;
    desc.force = swirl;
    desc.ledger = 1;
    desc.domain = box_of(-0.02, -0.02, -0.02, 0.05, 0.05, 0.05);
    desc.boundary[0] = DEM_BOUNDARY_PERIODIC;
    desc.boundary[2] = DEM_BOUNDARY_OUTFLOW;
    world = dem_world_create(&desc);
    glass = scene_material(world, 1e7, 0.3, 0.3, p->law == LAW_EPSD ? 0.1 : 0);
    wall = scene_floor(world, glass, -0.01, -0.01, 0.03, 0.03, 5, 5);
    motion.kind = DEM_MOTION_ROTATING;
    motion.axis = at(0.1, 0, 1);
    motion.point = at(0.006, 0.006, 0);
    motion.speed = 60;
    dem_wall_motion_set(world, wall, &motion);
    wall = scene_drum(world, glass, middle, middle, radius, 40);
    motion.axis = at(0, 0, 1);
    motion.point = at(middle, middle, 0);
    motion.speed = -40;
    dem_wall_motion_set(world, wall, &motion);
    wall = dem_wall_cylinder_add(world, glass, at(middle, middle, 0), at(0, 0, 1), (dem_real)radius, 1);
    dem_wall_motion_set(world, wall, &motion);
    wall = dem_wall_plane_add(world, glass, at(0, 0, 0), at(0, 0, 1));
    motion.kind = DEM_MOTION_OSCILLATING;
    motion.velocity = at(0, 0, 1);
    motion.amplitude = DEM_R(1e-4);
    motion.frequency = 300;
    motion.phase = DEM_R(0.5);
    dem_wall_motion_set(world, wall, &motion);
    scene_block(world, glass, p->nx, p->ny, p->nz, 1e-3, 1, 0.2, 7);
    memset(&field, 0, sizeof field);
    field.box = box_of(0, 0, 0, 0.01, 0.01, 0.01);
    for (k = 0; k < 3; k++) field.cells[k] = 4;
    field.interval = 3.3e-5;
    dem_field_add(world, &field);
    return world;
}
/* On to step `to`; grains come and go on the way, never at the step of a checkpoint. */
static void play_on(dem_world *world, const play *p, int to) {
    const int events[] = {p->steps/3, p->steps*4/3};
    int i;
    for (i = 0; i < 2; i++) {
        const int now = (int)dem_world_steps_get(world);
        dem_material glass;
        dem_body b;
        if (now >= events[i] || to <= events[i] || (i && !p->late)) continue;
        CHECK_EQ(scene_step(world, events[i] - now), DEM_OK);
        glass.id = 1;
        b = dem_sphere_add(world, glass, DEM_R(1e-3),
                           at(0.004, 0.004, 1.97e-3*p->nz + 1.2e-3 + 0.003*i));
        scene_move(world, b, at(0, 0.1, -2), at(5, 0, 0));
        b = dem_body_id_get(world, 10);
        CHECK_EQ(dem_body_remove(world, b), DEM_OK);
    }
    CHECK_EQ(scene_step(world, to - (int)dem_world_steps_get(world)), DEM_OK);
}
static void check_same(const dem_world *a, const dem_world *b) {
    const dem_ledger la = dem_ledger_get(a), lb = dem_ledger_get(b);
    const dem_body_counts ba = dem_body_counts_get(a), bb = dem_body_counts_get(b);
    const dem_counters ca = dem_counters_get(a), cb = dem_counters_get(b);
    dem_field_data fa, fb;
    dem_field field;
    int i;
    field.id = 1;
    CHECK_EQ(dem_world_hash_get(a), dem_world_hash_get(b));
    CHECK_EQ(dem_world_steps_get(a), dem_world_steps_get(b));
    CHECK(dem_world_time_get(a) >= dem_world_time_get(b) && dem_world_time_get(a) <= dem_world_time_get(b));
    CHECK(memcmp(&la, &lb, sizeof la) == 0);
    CHECK(memcmp(&ba, &bb, sizeof ba) == 0);
    CHECK_EQ(ca.contacts, cb.contacts);
    CHECK_EQ(ca.candidates, cb.candidates);
    CHECK_EQ(ca.rebuilds, cb.rebuilds);
    CHECK(memcmp(&ca.overlap_max, &cb.overlap_max, sizeof ca.overlap_max) == 0);
    CHECK(memcmp(&ca.dt, &cb.dt, sizeof ca.dt) == 0);
    if (dem_field_get(a, field, &fa) == DEM_OK && dem_field_get(b, field, &fb) == DEM_OK) {
        const size_t n = (size_t)(fa.cells[0]*fa.cells[1]*fa.cells[2])*sizeof(double);
        CHECK_EQ(fa.samples, fb.samples);
        CHECK(memcmp(fa.solid, fb.solid, n) == 0);
        CHECK(memcmp(fa.mass, fb.mass, n) == 0);
        CHECK(memcmp(fa.momentum, fb.momentum, 3*n) == 0);
    }
    for (i = 1; i <= 4; i++) {
        dem_wall_loads wa, wb;
        dem_pose pa, pb;
        dem_wall wall;
        wall.id = i;
        if (dem_wall_loads_get(a, wall, &wa) || dem_wall_loads_get(b, wall, &wb)) continue;
        CHECK(memcmp(wa.impulse, wb.impulse, sizeof wa.impulse) == 0);
        CHECK(memcmp(&wa.force, &wb.force, sizeof wa.force) == 0);
        CHECK(memcmp(&wa.work, &wb.work, sizeof wa.work) == 0);
        dem_wall_pose_get(a, wall, &pa);
        dem_wall_pose_get(b, wall, &pb);
        CHECK(memcmp(&pa.position, &pb.position, sizeof pa.position) == 0);
        CHECK(memcmp(pa.rotation, pb.rotation, sizeof pa.rotation) == 0);
    }
}
/* Straight through; interrupted and gone on with; read into a new world; read into one that has
   lived. */
static void play_both(const play *p) {
    dem_world *straight = play_world(p), *first = play_world(p), *second = play_world(p);
    play_on(straight, p, 2*p->steps);
    play_on(first, p, p->steps);
    CHECK(dem_counters_get(first).contacts > 10);
    CHECK(dem_counters_get(first).wall_contacts > 0);
    CHECK_EQ(dem_checkpoint_write(first, path), DEM_OK);
    CHECK_EQ(dem_checkpoint_read(second, path), DEM_OK);
    check_same(first, second);
    play_on(first, p, 2*p->steps);
    play_on(second, p, 2*p->steps);
    check_same(straight, first);
    check_same(straight, second);
    CHECK_EQ(dem_checkpoint_read(second, path), DEM_OK);
    play_on(second, p, 2*p->steps);
    check_same(straight, second);
    dem_world_destroy(straight);
    dem_world_destroy(first);
    dem_world_destroy(second);
    remove(path);
}

static char *file_get(const char *name, size_t *size) {
    FILE *f = fopen(name, "rb");
    char *data = 0;
    *size = 0;
    if (!f) return 0;
    fseek(f, 0, SEEK_END);
    *size = (size_t)ftell(f);
    rewind(f);
    data = (char *)malloc(*size + 1);
    if (data && fread(data, 1, *size, f) != *size) *size = 0;
    fclose(f);
    return data;
}
static void file_put(const char *name, const char *data, size_t size) {
    FILE *f = fopen(name, "wb");
    CHECK(f != 0);
    if (!f) return;
    CHECK(fwrite(data, 1, size, f) == size);
    fclose(f);
}
/* Two grains on a plane with friction. */
static dem_world *tiny_world(double density) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = scene_stuff(1e7, 0.7, 0.3, 0);
    dem_material glass;
    dem_world *world;
    desc.threads = 1;
    desc.dt = DEM_R(1e-6);
    desc.gravity = at(0, 0, -9.81);
    world = dem_world_create(&desc);
    stuff.density = (dem_real)density;
    glass = dem_material_add(world, &stuff);
    dem_wall_plane_add(world, glass, at(0, 0, 0), at(0, 0, 1));
    dem_sphere_add(world, glass, DEM_R(1e-3), at(0, 0, 0.99e-3));
    dem_sphere_add(world, glass, DEM_R(1e-3), at(1.98e-3, 0, 0.99e-3));
    scene_step(world, 5);
    return world;
}
/* The file at `path` must be refused, with the file's name and `why`, and the world as it was. */
static void refused(dem_world *world, dem_result code, const char *why) {
    const uint64_t hash = dem_world_hash_get(world);
    const uint64_t steps = dem_world_steps_get(world);
    CHECK_EQ(dem_checkpoint_read(world, path), code);
    CHECK_STR(dem_world_error_get(world), "dem_checkpoint_read: ");
    CHECK_STR(dem_world_error_get(world), path);
    CHECK_STR(dem_world_error_get(world), why);
    CHECK_EQ(dem_world_hash_get(world), hash);
    CHECK_EQ(dem_world_steps_get(world), steps);
}

/* Another scene: what of it differs from that of the file. */
enum { SAME, DENSITY, PAIR, GRAVITY, INTEGRATOR, WALL_MORE, TRIANGLES, SHARE, MOTION_KIND,
    FIELD_BOX,
       FIELD_CELLS, EDGE_RULE, OTHERS };
static dem_world *other_world(int what) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = scene_stuff(1e7, 0.7, 0.3, 0);
    dem_material glass;
    dem_world *world;
    dem_motion motion = DEM_MOTION;
    dem_wall wall;
    dem_field_desc field;
    dem_mesh mesh;
    dem_profile profile;
    dem_real corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, line[] = {0, 0, 1, 0, 2, 0};
    int32_t triangles[] = {0, 1, 2, 1, 3, 2}, segments[] = {0, 1, 1, 2};
    int k;
    desc.threads = 1;
    desc.gravity = at(0, 0, what == GRAVITY ? -9.80 : -9.81);
    if (what == INTEGRATOR) desc.integrator = DEM_INTEGRATOR_LEAPFROG;
    world = dem_world_create(&desc);
    if (what == DENSITY) stuff.density = 2501;
    glass = dem_material_add(world, &stuff);
    if (what == PAIR) {
        dem_pair pair;
        dem_pair_get(world, glass, glass, &pair);
        pair.tangent_damping = DEM_R(0.5);
        dem_pair_set(world, glass, glass, &pair);
    }
    mesh.vertex_count = 4; mesh.triangle_count = 2;
    mesh.vertices = corners; mesh.triangles = triangles;
    if (what == TRIANGLES) triangles[2] = 3;
    wall = dem_wall_mesh_add(world, glass, &mesh);
    motion.kind = what == MOTION_KIND ? DEM_MOTION_TRANSLATING : DEM_MOTION_OSCILLATING;
    motion.velocity = at(0, 0, 1);
    motion.amplitude = DEM_R(1e-3);
    motion.frequency = 10;
    dem_wall_motion_set(world, wall, &motion);
    dem_wall_grains_add(world, glass, 4, corners, DEM_R(0.1), what == SHARE ? DEM_R(0.5) : 1);
    profile.vertex_count = 3; profile.segment_count = 2;
    profile.vertices = line; profile.segments = segments;
    dem_wall_profile_add(world, glass, &profile,
                    what == EDGE_RULE ? DEM_EDGE_FRACTION : DEM_EDGE_RESOLVED);
    if (what == WALL_MORE) dem_wall_plane_add(world, glass, at(0, 0, -1), at(0, 0, 1));
    memset(&field, 0, sizeof field);
    field.box = box_of(0, 0, 0, what == FIELD_BOX ? 2 : 1, 1, 1);
    for (k = 0; k < 3; k++) field.cells[k] = what == FIELD_CELLS && k == 0 ? 3 : 2;
    dem_field_add(world, &field);
    return world;
}

static int no_call(dem_world *w, int64_t number, void *user) { (void)w; (void)number; (void)user; return 0; }
/* Spheres, a cluster and an ellipsoid in a heap, a plane, a mesh, a feed, an outlet, a field, an output. */
static dem_world *rich_world(int steps) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_cluster_desc two = DEM_CLUSTER_DESC;
    dem_feed_desc feed;
    dem_outlet_desc outlet;
    dem_field_desc field;
    dem_output_desc call = DEM_OUTPUT_DESC;
    dem_motion motion = DEM_MOTION;
    dem_material glass;
    dem_world *world;
    dem_shape pair, egg;
    dem_real centres[6] = {0, 0, 0, DEM_R(5e-4), 0, 0};
    int i;
    desc.threads = 1;
    desc.dt = DEM_R(1e-6);
    desc.gravity = at(0, 0, -9.81);
    world = dem_world_create(&desc);
    glass = scene_material(world, 1e7, 0.7, 0.3, 0);
    dem_wall_plane_add(world, glass, at(0, 0, 0), at(0, 0, 1));
    motion.kind = DEM_MOTION_TRANSLATING;
    motion.velocity = at(1e-3, 0, 0);
    dem_wall_motion_set(world, scene_floor(world, glass, -0.01, -0.01, 0.01, 0.01, 2, 2), &motion);
    two.count = 2; two.positions = centres; two.radius = DEM_R(6e-4);
    pair = dem_shape_cluster_add(world, &two);
    egg = dem_shape_ellipsoid_add(world, at(1e-3, 8e-4, 1.1e-3));
    for (i = 0; i < 12; i++) {
        const dem_vec3 x = at(i%3*1.7e-3, i/3%2*1.7e-3, 0.8e-3 + i/6*1.7e-3);
        if (i%4 == 2) dem_body_add(world, glass, i%3 ? pair : egg, x, dem_quat_make(1, 0, 0, 0));
        else dem_sphere_add(world, glass, DEM_R(0.9e-3), x);
    }
    memset(&feed, 0, sizeof feed);
    feed.material = glass; feed.class_count = 2; feed.limited = 1; feed.rate = 1;
    feed.radius[0] = DEM_R(1e-3); feed.radius[1] = DEM_R(2e-3);
    feed.amount[0] = feed.amount[1] = 5;
    feed.box = box_of(-0.1, -0.1, 0.5, 0.1, 0.1, 0.6);
    dem_feed_add(world, &feed);
    memset(&outlet, 0, sizeof outlet);
    outlet.box = box_of(0, 0, 7, 1, 1, 8);
    dem_outlet_add(world, &outlet);
    memset(&field, 0, sizeof field);
    field.box = box_of(0, 0, 0, 1, 1, 1);
    for (i = 0; i < 3; i++) field.cells[i] = 2;
    dem_field_add(world, &field);
    call.function = no_call;
    call.start = call.interval = 1;
    dem_output_add(world, &call);
    scene_step(world, steps);
    dem_body_remove(world, dem_body_id_get(world, 0));     /* a slot that rests */
    scene_step(world, steps ? 1 : 0);
    return world;
}
/* Makes a number of the world NaN, if its row has limits. */
static int lie_row(dem_world *w, const demi_field_row *r) {
    const double d = HUGE_VAL - HUGE_VAL;
    const dem_real x = (dem_real)d;
    char *at = (char *)w + r->offset;
    if (!(r->how & DEMI_LIMITS) || !strchr("drv", r->type)) return 0;
    if (r->type == 'd') memcpy(at, &d, sizeof d);
    else memcpy(at, &x, sizeof x);
    return 1;
}
/* Puts one lie into the world that is about to be written: some number that cannot be. Answers 0
   when there is no lie of that number. Those of 100 and more are about a world without a list. */
static int lie_tell(dem_world *w, int lie) {
    demi_domain *o = &w->domains[0];
    demi_feed *f = demi_feed_at(w, 0);
    const int huge = 0x7fffffff, twice = w->near.k[1];
    int shaped = 0, kept_wall = 0;
    if (lie >= 200) return lie_row(w, demi_number_rows + (lie - 200));
    while (!w->bodies.shape[shaped]) shaped++;
    while (kept_wall + 1 < o->persistent && w->persistent_now[kept_wall].b >= 0) kept_wall++;
    switch (lie) {
    case 0: w->bodies.balance.present++; break;
    case 1: w->bodies.slot_count = huge; break;
    case 2: w->domain_count = 257; break;
    case 3: w->domain_count = 0; break;
    case 4: w->bodies.shaped = 13; break;
    case 5: w->bodies.shaped--; break;
    case 6: w->bodies.slot_free = 77; break;
    case 7: w->bodies.slot_pending = 1; break;
    case 8: w->bodies.slot_free = -2; break;
    case 9: w->effects.tangent = DEM_TANGENT_MINDLIN; break;
    case 10: w->effects.rolling = 99; break;
    case 11: w->clock.dt = DEM_R(-1e-6); break;
    case 12: w->clock.dt = 0; break;
    case 13: w->clock.dt = DEM_R(2e-6); break;
    case 14: w->clock.time = HUGE_VAL; break;
    case 15: w->clock.time = 1e30; break;
    case 16: w->margin.skin = -1; break;
    case 17: w->margin.span = -1; break;
    case 18: w->margin.slack = HUGE_VAL; break;
    case 19: w->effects.uniform = 2; break;
    case 20: o->own = -1; break;
    case 21: o->own = huge; break;
    case 22: o->cross = 1; break;
    case 23: o->walls = huge/2; break;
    case 24: o->near_own++; break;
    case 25: o->near_end = -4; break;
    case 26: o->near_shaped = 1 << 20; break;
    case 27: o->near_shaped_end = huge; break;
    case 28: o->near_shaped_cross = 0; break;
    case 29: o->persistent = huge/64; break;
    case 30: o->persistent = -7; break;
    case 31: o->begin = 1; break;
    case 32: o->end = 12345; break;
    case 33: w->own.a[0] = -1; break;
    case 34: w->own.b[0] = w->bodies.count; break;
    case 35: w->own.b[0] = w->own.a[0]; break;
    case 36: w->near.k[0] = huge; break;
    case 37: w->near.k[0] = -1; break;
    case 38: w->near.k[0] = twice; break;
    case 39: w->near.a[0] = 12345678; break;
    case 40: w->near.b[0] = -3; break;
    case 41: w->wall_body[0] = 999; break;
    case 42: w->wall_id[0] = w->wall_count + w->surface_count; break;
    case 43: w->wall_element[0] = 1 << 30; break;
    case 44: w->persistent_now[kept_wall].a = -1; break;
    case 45: w->persistent_now[kept_wall].wall = 7; break;
    case 46: w->persistent_now[0].a = 1 << 20; break;
    case 47: w->persistent_now[0].b = -2; break;
    case 48: w->bodies.slot[0] = 0xffffffffu; break;
    case 49: w->bodies.slot[0] = w->bodies.slot[1]; break;
    case 50: w->bodies.slot_index[w->bodies.slot[0]] = 5; break;
    case 51: w->bodies.material[0] = 0; break;
    case 52: w->bodies.material[0] = 2; break;
    case 53: w->bodies.shape[shaped] = 3; break;
    case 54: w->bodies.shape[shaped] = -1; break;
    case 55: w->bodies.pos[3] = 0; break;
    case 56: w->bodies.pos[0] = DEM_R(1e20); break;
    case 57: w->bodies.mass[0] = -1; break;
    case 58: w->bodies.orient[0] = 3; break;
    case 59: w->bodies.moment[4*shaped] = 0; break;
    case 60: w->walls[1].pose.rotation[0] = DEM_R(1e30); break;
    case 61: w->walls[1].motion.kind = (dem_motion_kind)DEM_MOTION_USER; break;
    case 62: w->fields[0].next = HUGE_VAL; break;
    case 63: f->next = 2; break;
    case 64: f->next = -5; break;
    case 65: f->state.fed[0] = 6; break;
    case 66: w->filed.count = 1; break;
    case 67: w->look.output_count = huge; break;
    case 68: w->look.outputs[0].written.next = -7; break;
    case 69: w->look.outputs[0].written.last = HUGE_VAL; break;
    case 100: w->filed.rows = huge; break;
    case 101: w->filed.stride = 9; break;
    case 102: w->filed.count = huge; break;
    case 103: w->filed.start[1] = -1; break;
    case 104: w->filed.start[w->filed.rows] = 0; break;
    case 105: w->filed.partner[0] = 12345; break;
    case 106: w->filed.partner[0] = ~12345; break;
    case 107: w->persistent_now[kept_wall].a = w->bodies.slot_count; break;
    case 108: w->persistent_now[0].a = -1; break;
    default: return 0;
    }
    return 1;
}
/* Writes a checkpoint with a lie and the check sum that goes with it. Counts that lie are written as
   they are, but what follows is as long as it was. */
static int lie_write(dem_world *w, int lie) {
    const dem_world truth = *w;
    demi_domain *domains = (demi_domain *)malloc(DEMI_DOMAINS*sizeof *domains);
    demi_stream s = {0, 0, 0, 0, 0, 0, 0};
    size_t size;
    char *data;
    int told;
    CHECK_EQ(dem_checkpoint_write(w, path), DEM_OK);
    data = file_get(path, &size);
    memcpy(domains, w->domains, DEMI_DOMAINS*sizeof *domains);
    told = lie_tell(w, lie);
    demi_visit_scene(&truth, &s);
    size = sizeof(demi_checkpoint_head) + s.size;
    s.file = fopen(path, "wb");
    s.sum = DEMI_HASH_START;
    demi_visit(&s, data, size);
    demi_visit_numbers(w, &s);
    demi_visit(&s, w->domains, (size_t)truth.domain_count*sizeof *domains);
    *w = truth;
    memcpy(w->domains, domains, DEMI_DOMAINS*sizeof *domains);
    demi_visit_bodies(w, &s);
    demi_visit_lists(w, &s);
    demi_visit_contacts(w, &s);
    demi_visit_walls(w, &s);
    DEMI_ALL_FEATURES(visit, (w, &s))
    w->written_count = w->look.output_count;
    demi_visit_outputs(w, &s);
    fwrite(&s.sum, 1, sizeof s.sum, s.file);
    fclose(s.file);
    free(domains);
    free(data);
    return told;
}

/* The allocator of a program whose memory was used before. */
static void *used_alloc(size_t size, void *user) {
    void *p = malloc(size);
    (void)user;
    if (p) memset(p, 0x7f, size);
    return p;
}
static void used_free(void *p, size_t size, void *user) { (void)size; (void)user; free(p); }
/* Three grains of different size in a row. */
static dem_world *row_world(double friction, dem_material *stuff) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    desc.threads = 1;
    desc.allocator.alloc_fn = used_alloc;
    desc.allocator.free_fn = used_free;
    world = dem_world_create(&desc);
    *stuff = scene_material(world, 1e7, 0.5, friction, 0);
    return world;
}
static void row_add(dem_world *world, dem_material stuff) {
    dem_sphere_add(world, stuff, DEM_R(1e-3), at(0, 0, 0));
    dem_sphere_add(world, stuff, DEM_R(1.5e-3), at(2.49e-3, 0, 0));
    dem_sphere_add(world, stuff, DEM_R(2e-3), at(-2.99e-3, 0, 0));
}

/* --- all that a body keeps: the arrays that dem.h's table declares --- */

/* Spheres and ellipsoids in turn, by a scheme that looks back: every array there is exists. */
static dem_world *kept_world(int count) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material stuff;
    dem_world *world;
    dem_outlet_desc counting;
    dem_field_desc averages;
    dem_shape egg;
    int i;
    desc.integrator = DEM_INTEGRATOR_POSITION_VERLET;
    desc.orientations = 1;
    desc.ledger = 1;                            /* what predictions fell short by */
    desc.dt = DEM_R(1e-6);
    desc.body_reals = "a b c d e f";
    desc.groups = "a b c";
    world = dem_world_create(&desc);
    stuff = scene_material(world, 1e7, 0.5, 0.3, 0);
    egg = dem_shape_ellipsoid_add(world, at(1, 2, 3));
    memset(&counting, 0, sizeof counting);
    counting.keep = 1;
    counting.box = box_of(0, 0, 7, 1, 1, 8);
    counting.residence_bin = 1;
    dem_outlet_add(world, &counting);
    memset(&averages, 0, sizeof averages);
    averages.box = box_of(0, 0, 0, 1, 1, 1);
    averages.cells[0] = averages.cells[1] = averages.cells[2] = 1;
    averages.bodies = 1;
    dem_field_add(world, &averages);
    for (i = 0; i < count; i++) {
        if (i%3) dem_body_add(world, stuff, egg, at(10*i, 0, 0), dem_quat_make(1, 0, 0, 0));
        else dem_sphere_add(world, stuff, 1, at(10*i, 0, 0));
    }
    return world;
}
/* Any numbers into all reals that bodies keep; only orientations have to be of length 1. */
static void kept_fill(dem_world *w, uint64_t seed) {
    size_t e;
    int i, k;
    for (k = 0; k < DEMI_BODY_ARRAYS; k++) {
        const demi_body_array *a = &demi_body_arrays[k];
        for (i = 0; i < w->bodies.count && a->what >= DEMI_REALS; i++)
            for (e = 0; e < demi_item(w, a)/sizeof(dem_real); e++) {
                const dem_real x = (dem_real)(0.5 + scene_random(&seed));
                memcpy(demi_datum(w, a, i) + e*sizeof x, &x, sizeof x);
            }
    }
    for (i = 0; i < w->bodies.count; i++) {
        w->bodies.zones[i] = (uint32_t)(65536*scene_random(&seed));
        w->bodies.born[i] = -scene_random(&seed);
        for (k = 0; k < DEMI_MEANS; k++) w->bodies.means[DEMI_MEANS*i + k] = scene_random(&seed);
        demi_quat_put(w->bodies.orient + 4*i, demi_quat_unit(demi_quat_at(w->bodies.orient + 4*i)));
    }
}
/* All that the body of a slot keeps, one array after the other; answers how many bytes. */
static size_t kept_row(const dem_world *w, int slot, char *out) {
    size_t size = 0;
    int k;
    for (k = 0; k < DEMI_BODY_ARRAYS; k++) {
        const demi_body_array *a = &demi_body_arrays[k];
        if (!a->what || a->who == DEMI_SLOTS) continue;
        memcpy(out + size, demi_datum(w, a, w->bodies.slot_index[slot]), demi_item(w, a));
        size += demi_item(w, a);
    }
    return size;
}
/* Slots whose bodies do not keep the same in both worlds; bodies of one that are not in the other. */
static int kept_differ(const dem_world *a, const dem_world *b) {
    char x[1024], y[1024];
    int slot, n = 0;
    for (slot = 0; slot < a->bodies.slot_count; slot++) {
        size_t size;
        if (b->bodies.slot_index[slot] < 0) continue;
        if (a->bodies.slot_index[slot] < 0) { n++; continue; }
        size = kept_row(a, slot, x);
        n += kept_row(b, slot, y) != size || memcmp(x, y, size);
    }
    return n;
}

/* --- every field of every desc --- */

/* Fields that no single change of a value leaves both accepted and different: with why. */
static int walk_alone(const char *name) {
    static const char *const none[] = {
        "world.allocator.alloc_fn", "world.allocator.free_fn",      /* both or neither */
        0};
    int k;
    for (k = 0; none[k]; k++) if (!strcmp(none[k], name)) return 1;
    return 0;
}
/* What a run leaves behind, as a checkpoint has it. */
static char *walk_bytes(dem_world *world, size_t *size) {
    *size = 0;
    return dem_checkpoint_write(world, path) == DEM_OK ? file_get(path, size) : 0;
}
/* A checkpoint of one scene read into another: 0: refused, and the sentence says both values; 1: goes on to the
   last byte as the scene that wrote it; -1: wrong. */
static int walk_into(const walk_scene *from, const walk_scene *to, char *why) {
    dem_world *a = walk_make(from, 0), *b = walk_make(to, 0);
    char *x, *y;
    size_t m, n;
    int how = 0;
    if (scene_step(a, 20) != DEM_OK || dem_checkpoint_write(a, path) != DEM_OK) how = -1;
    else if (dem_checkpoint_read(b, path) != DEM_OK) {
        snprintf(why, 512, "%s", dem_world_error_get(b));
        how = (strstr(why, "written with ") && (strstr(why, ", this world has ") || strstr(why, " than those of this world"))) ||
            (strstr(why, "the checkpoint has ") && strstr(why, ", this world ")) ? 0 : -1;
    } else {
        const dem_result ra = dem_world_step(a, 100), rb = dem_world_step(b, 100);
        x = walk_bytes(a, &m);
        y = walk_bytes(b, &n);
        /* when a time step is judged next depends on whether it is judged */
        how = ra == rb && dem_world_hash_get(a) == dem_world_hash_get(b) && x && y && m == n &&
            (from->world.allow_large_dt != to->world.allow_large_dt || !memcmp(x, y, m)) ? 1 : -1;
        free(x);
        free(y);
        snprintf(why, 512, "read, and it goes on %s: %s", how < 0 ? "otherwise" : "alike", dem_world_error_get(b));
    }
    dem_world_destroy(a);
    dem_world_destroy(b);
    return how;
}

/* Is what was accepted, before its first step and after five that went well, written and read? */
static int walk_again(dem_world *world, char *why) {
    int k;
    for (k = 0; k < 2; k++) {
        if (k && dem_world_step(world, 5) != DEM_OK) return 1;
        if (dem_checkpoint_write(world, path) == DEM_OK && dem_checkpoint_read(world, path) == DEM_OK) continue;
        snprintf(why, 512, "%s, %d steps", dem_world_error_get(world), 5*k);
        return 0;
    }
    return 1;
}

static dem_real larger(const dem_body_state *body, dem_body id, double time, void *user) {
    (void)id;
    (void)time;
    (void)user;
    return DEM_R(0.3)*body->radius;
}
int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("a checkpoint of any world that a desc allows can be read, before the first step and after steps") {
        static const double numbers[] = {1e16, -1e16, 1e30, -1e30, 1e155, 1e300, -1e300, 1e-30, 1e-300, 0};
        const walk_fields *all = walk_all();
        int k, way, n, accepted = 0, refusals = 0;
        for (k = 0; k < all->count; k++)
            for (n = 0; n < (int)(sizeof numbers/sizeof *numbers); n++)
                for (way = 0; way < WALKS && (all->field[k].type == 'r' || all->field[k].type == 'd'); way++) {
                    walk_scene s = walk_begin((k + n + way)%WALKS);    /* one scene that accepts it */
                    char why[512] = "";
                    dem_world *world;
                    int good;
                    walk_put(&all->field[k], &s, numbers[n]);
                    world = walk_make(&s, 0);
                    if (!world) { refusals++; continue; }
                    accepted++;
                    good = walk_again(world, why);
                    CHECK(good);
                    if (!good) printf("        %s = %g in scene %d: %s\n", all->field[k].name, numbers[n], (k + n + way)%WALKS, why);
                    dem_world_destroy(world);
                    break;
                }
        CHECK(accepted > 500 && refusals > 500);
        remove(path);
    }

    TEST("each desc field that differs from the checkpoint's is rejected with both values, or the run resumes with "
         "the same bits") {
        const walk_fields *all = walk_all();
        int k, kind, way, refusals = 0, alike = 0;
        for (k = 0; k < all->count; k++) {
            const walk_field *f = &all->field[k];
            int reached = 0;
            char why[512] = "";
            for (kind = 0; kind < WALKS; kind++)
                for (way = 0; way < 6; way++) {
                    const walk_scene base = walk_begin(kind);
                    walk_scene other = base;
                    dem_world *world;
                    int how;
                    if (!walk_change(f, &other, way)) break;
                    if (!memcmp(&other, &base, sizeof base)) continue;
                    world = walk_make(&other, why);
                    if (!world) continue;
                    dem_world_destroy(world);
                    reached = 1;
                    how = walk_into(&base, &other, why);
                    CHECK(how >= 0);
                    if (how < 0) printf("        %s in scene %d, change %d: %s\n", f->name, kind, way, why);
                    refusals += how == 0;
                    alike += how == 1;
                    break;                       /* one value in each scene is enough */
                }
            CHECK(reached || walk_alone(f->name));
            if (!reached && !walk_alone(f->name)) printf("        %s: no other value is accepted: %s\n", f->name, why);
        }
        CHECK(refusals > 300 && alike > 10);
        remove(path);
    }

    TEST("every byte of a body survives a checkpoint, a sort, a removal and a message to another slab") {
        dem_world *a = kept_world(40), *b = kept_world(40), *c = kept_world(40);
        demi_message message = {0, 0};
        const char *from;
        int i, arrays = 0;
        for (i = 0; i < DEMI_BODY_ARRAYS; i++) {
            CHECK(demi_has(a, &demi_body_arrays[i]));
            arrays += demi_body_arrays[i].what && demi_body_arrays[i].who != DEMI_SLOTS;
        }
        CHECK(arrays >= 17);
        kept_fill(a, 7);
        kept_fill(c, 7);
        CHECK_EQ(kept_differ(a, c), 0);
        CHECK_EQ(kept_differ(a, b), 40);
        CHECK_EQ(dem_checkpoint_write(a, path), DEM_OK);
        CHECK_EQ(dem_checkpoint_read(b, path), DEM_OK);
        CHECK_EQ(b->bodies.count, 40);
        CHECK_EQ(kept_differ(a, b), 0);

        CHECK(demi_grid_lay(b, 0.1));
        demi_bodies_sort(b);
        CHECK_EQ(kept_differ(a, b), 0);
        for (i = 0; i < 39 && b->bodies.slot[i] < b->bodies.slot[i + 1];) i++;
        CHECK(i < 39);                          /* they do stand in another order */

        for (i = 0; i < 20; i++) demi_body_take_out(b, (7*i)%b->bodies.count);
        CHECK_EQ(b->bodies.count, 20);
        CHECK_EQ(kept_differ(a, b), 0);

        kept_fill(c, 8);
        CHECK_EQ(kept_differ(a, c), 40);
        for (i = 0; i < 40; i++) CHECK(demi_grain_put(a, &message, a, i, 0, 0));
        CHECK_EQ((int)message.size, 40*(int)demi_body_size(a));
        from = message.bytes;
        for (i = 0; i < 40; i++) {
            const int slot = (int)demi_grain_slot(from);
            demi_grain_unpack(c, c->bodies.slot_index[slot], &from);
        }
        CHECK_EQ(kept_differ(a, c), 0);
        dem_world_destroy(a);
        dem_world_destroy(b);
        dem_world_destroy(c);
        remove(path);
    }

    TEST("2N steps are N, a checkpoint and N, when the time step and the skin are chosen by the "
         "library") {
        play p = play_make(DEM_INTEGRATOR_VELOCITY_VERLET, LAW_MINDLIN);
        p.dt = 0;
        play_both(&p);
    }
    TEST("2N steps are N, a checkpoint and N, with several domains and threads") {
        play p = play_make(DEM_INTEGRATOR_VELOCITY_VERLET, LAW_EPSD);
        dem_world *world;
        p.nx = p.ny = 16; p.nz = 17;
        p.steps = 9;
        p.threads = 2;
        world = play_world(&p);
        scene_step(world, 1);
        CHECK(dem_counters_get(world).domains > 1);
        dem_world_destroy(world);
        play_both(&p);
    }
    TEST("a checkpoint between an insertion and the next step keeps the history of the other contacts") {
        int removal;
        for (removal = 0; removal < 2; removal++) {
            play p = play_make(DEM_INTEGRATOR_VELOCITY_VERLET, LAW_SPRING);
            dem_world *first, *second;
            dem_material glass;
            glass.id = 1;
            p.late = 0;
            first = play_world(&p);
            second = play_world(&p);
            play_on(first, &p, p.steps);
            if (removal) dem_body_remove(first, dem_body_id_get(first, 3));
            else dem_sphere_add(first, glass, DEM_R(1e-3), at(0.004, 0.004, 0.0085));
            CHECK_EQ(dem_checkpoint_write(first, path), DEM_OK);
            CHECK_EQ(dem_checkpoint_read(second, path), DEM_OK);
            CHECK_EQ(dem_world_hash_get(first), dem_world_hash_get(second));
            play_on(first, &p, 2*p.steps);
            play_on(second, &p, 2*p.steps);
            check_same(first, second);
            dem_world_destroy(first);
            dem_world_destroy(second);
        }
        remove(path);
    }
    TEST("a checkpoint holds no addresses and no padding: equal states give equal bytes") {
        char *file[2];
        size_t size[2];
        int i, user[2] = {0, 0};
        for (i = 0; i < 2; i++) {
            dem_world *world = tiny_world(2500);
            dem_wall wall;
            dem_motion motion;
            memset(&motion, i ? 0xa5 : 0x5a, sizeof motion);       /* between its fields, too */
            motion.kind = DEM_MOTION_USER;
            motion.velocity = motion.point = at(0, 0, 0);
            motion.axis = at(0, 0, 1);
            motion.speed = motion.amplitude = motion.frequency = motion.phase = 0;
            motion.start = 0;
            motion.function = stand_still;
            motion.user = &user[i];
            motion.ramp = 0;
            motion.load = motion.area = motion.travel = 0;
            motion.table = 0;
            motion.table_count = motion.table_repeats = 0;
            wall.id = 1;
            CHECK_EQ(dem_wall_motion_set(world, wall, &motion), DEM_OK);
            scene_step(world, 30);
            CHECK_EQ(dem_checkpoint_write(world, path), DEM_OK);
            file[i] = file_get(path, &size[i]);
            dem_world_destroy(world);
        }
        CHECK_EQ((int)size[0], (int)size[1]);
        CHECK(size[0] == size[1] && !memcmp(file[0], file[1], size[0]));
        free(file[0]);
        free(file[1]);
        remove(path);
    }
    TEST("a motion set in mid-run resumes from a checkpoint with the same bits") {
        int kind;
        for (kind = DEM_MOTION_TRANSLATING; kind <= DEM_MOTION_OSCILLATING; kind++) {
            dem_world *w[2];
            dem_wall wall;
            int i;
            wall.id = 2;
            for (i = 0; i < 2; i++) {
                dem_motion motion = DEM_MOTION;
                dem_material glass;
                w[i] = tiny_world(2500);
                glass.id = 1;
                scene_floor(w[i], glass, -0.01, -0.01, 0.01, 0.01, 1, 1);
                motion.kind = (dem_motion_kind)kind;
                motion.velocity = motion.axis = at(0, 0, 1);
                motion.speed = 5;
                motion.amplitude = DEM_R(1e-5);
                motion.frequency = 500;
                motion.phase = i ? 0 : 1;
                motion.ramp = 1e-4;
                scene_step(w[i], i ? 5 : 50);  /* the same motion, given at another time */
                CHECK_EQ(dem_wall_motion_set(w[i], wall, &motion), DEM_OK);
            }
            scene_step(w[0], 20);
            CHECK_EQ(dem_checkpoint_write(w[0], path), DEM_OK);
            if (dem_checkpoint_read(w[1], path) == DEM_OK) {   /* refusing would be right as well */
                scene_step(w[0], 50);
                scene_step(w[1], 50);
                CHECK_EQ(dem_world_hash_get(w[0]), dem_world_hash_get(w[1]));
            } else CHECK_STR(dem_world_error_get(w[1]), "another scene");
            dem_world_destroy(w[0]);
            dem_world_destroy(w[1]);
        }
        remove(path);
    }
    TEST("a checkpoint of a world without grains, or before its first step, can be read back") {
        play p = play_make(DEM_INTEGRATOR_LEAPFROG, LAW_SPRING);
        dem_world *a = play_world(&p), *b = play_world(&p), *c;
        CHECK_EQ(dem_checkpoint_write(a, path), DEM_OK);
        scene_step(b, 30);
        CHECK_EQ(dem_checkpoint_read(b, path), DEM_OK);
        play_on(a, &p, p.steps);
        play_on(b, &p, p.steps);
        check_same(a, b);
        dem_world_destroy(a);
        p.nz = 0;
        a = play_world(&p);
        c = play_world(&p);
        CHECK_EQ(scene_step(a, 3), DEM_OK);
        CHECK_EQ(dem_checkpoint_write(a, path), DEM_OK);
        CHECK_EQ(dem_checkpoint_read(b, path), DEM_OK);
        CHECK_EQ(dem_checkpoint_read(c, path), DEM_OK);
        CHECK_EQ(scene_step(a, 3), DEM_OK);
        CHECK_EQ(scene_step(b, 3), DEM_OK);
        CHECK_EQ(scene_step(c, 3), DEM_OK);
        check_same(a, c);
        CHECK_EQ(dem_world_hash_get(a), dem_world_hash_get(b));
        dem_world_destroy(a);
        dem_world_destroy(b);
        dem_world_destroy(c);
        remove(path);
    }
    TEST("a checkpoint cut at any byte is rejected with a named error and leaves the world unchanged") {
        dem_world *world = tiny_world(2500);
        size_t size, n;
        char *data;
        CHECK_EQ(dem_checkpoint_write(world, path), DEM_OK);
        data = file_get(path, &size);
        CHECK(size > 500);
        scene_step(world, 1);
        for (n = 0; n < size && test_now.wrong == 0; n++) {
            file_put(path, data, n);
            refused(world, DEM_ERROR_FORMAT, n < 8 ? "is not a checkpoint" : "cut short");
        }
        data[size] = 0;
        file_put(path, data, size + 1);
        refused(world, DEM_ERROR_FORMAT, "appended");
        file_put(path, data, size);
        CHECK_EQ(dem_checkpoint_read(world, path), DEM_OK);
        CHECK_EQ(dem_world_steps_get(world), 5);
        free(data);
        dem_world_destroy(world);
        remove(path);
    }
    TEST("a file that ends within the header and the checksum of a checkpoint is rejected, even if the last bytes are the checksum of the others and the stated size is their difference") {
        dem_world *world = tiny_world(2500);
        demi_checkpoint_head head;
        size_t size, n;
        char *data;
        CHECK_EQ(dem_checkpoint_write(world, path), DEM_OK);
        data = file_get(path, &size);
        for (n = 0; n < 8; n++) {
            const size_t length = sizeof head + n;
            uint64_t sum;
            memcpy(&head, data, sizeof head);
            head.body_size = (uint64_t)n - 8;           /* wraps */
            memcpy(data, &head, sizeof head);
            sum = demi_hash(DEMI_HASH_START, data, length - sizeof sum);
            memcpy(data + length - sizeof sum, &sum, sizeof sum);
            file_put(path, data, length);
            refused(world, DEM_ERROR_FORMAT, "cut short within its header");
        }
        free(data);
        dem_world_destroy(world);
        remove(path);
    }
    TEST("a checkpoint with any byte changed is rejected with a named error and leaves the world unchanged") {
        dem_world *world = tiny_world(2500);
        size_t size, n;
        char *data;
        CHECK_EQ(dem_checkpoint_write(world, path), DEM_OK);
        data = file_get(path, &size);
        scene_step(world, 1);
        for (n = 0; n < size && test_now.wrong == 0; n++) {
            const int bit = 1 << n%8;
            data[n] = (char)(data[n] ^ bit);
            file_put(path, data, size);
            refused(world, DEM_ERROR_FORMAT, "");
            data[n] = (char)(data[n] ^ bit);
        }
        free(data);
        dem_world_destroy(world);
        remove(path);
    }
    TEST("a checkpoint of another version, precision or byte order, or another file, is rejected with a named error") {
        dem_world *world = tiny_world(2500);
        size_t size;
        char *data, versions[64];
        CHECK_EQ(dem_checkpoint_write(world, path), DEM_OK);
        data = file_get(path, &size);
        data[8]++;
        file_put(path, data, size);
        snprintf(versions, sizeof versions, "version %d, must be %d", data[8], data[8] - 1);
        refused(world, DEM_ERROR_FORMAT, versions);
        data[8]--;
        data[12] = (char)(12 - data[12]);      /* 8 and 4 change places */
        file_put(path, data, size);
        refused(world, DEM_ERROR_FORMAT, "DEM_REAL");
        data[12] = (char)(12 - data[12]);
        data[16] = data[19];
        file_put(path, data, size);
        refused(world, DEM_ERROR_FORMAT, "byte order");
        file_put(path, "solid bunny", 11);
        refused(world, DEM_ERROR_FORMAT, "is not a checkpoint");
        remove(path);
        refused(world, DEM_ERROR_FILE, "cannot read");
        CHECK_EQ(dem_checkpoint_read(world, 0), DEM_ERROR_ARGUMENT);
        free(data);
        dem_world_destroy(world);
    }
    TEST("a checkpoint of another scene is rejected with the difference named, whichever it is") {
        dem_world *world = other_world(SAME);
        int what;
        CHECK_EQ(dem_checkpoint_write(world, path), DEM_OK);
        CHECK_EQ(dem_checkpoint_read(world, path), DEM_OK);
        dem_world_destroy(world);
        for (what = DENSITY; what < OTHERS; what++) {
            const int before = test_now.wrong;
            world = other_world(what);
            refused(world, DEM_ERROR_FORMAT, "another scene");
            if (test_now.wrong > before) printf("        with difference %d\n", what);
            dem_world_destroy(world);
        }
        remove(path);
    }
    TEST("a checkpoint between dem_pair_set or dem_material_add and the next step resumes with the same bits") {
        int how;
        for (how = 0; how < 3; how++) {
            dem_contact_info ca[8], cb[8];
            dem_world *w[2];
            dem_material stuff, more;
            dem_pair pair;
            int i;
            for (i = 0; i < 2; i++) {
                w[i] = row_world(how == 2 ? 0.4 : 0, &stuff);
                row_add(w[i], stuff);
                scene_move(w[i], dem_body_id_get(w[i], 1), at(0, 0.1, 0), at(1, 2, 3));
                scene_step(w[i], 3);
                if (how == 0) {
                    more = scene_material(w[i], 1e7, 0.5, 0.5, 0);
                    CHECK(more.id == 2);
                } else {
                    dem_pair_get(w[i], stuff, stuff, &pair);
                    pair.friction = pair.friction_static = how == 1 ? DEM_R(0.5) : 0;
                    CHECK_EQ(dem_pair_set(w[i], stuff, stuff, &pair), DEM_OK);
                }
            }
            CHECK_EQ(dem_checkpoint_write(w[0], path), DEM_OK);
            CHECK_EQ(dem_checkpoint_read(w[1], path), DEM_OK);
            CHECK_EQ(dem_world_hash_get(w[1]), dem_world_hash_get(w[0]));
            CHECK_EQ(dem_contacts_get(w[0], ca, 8), 2);
            CHECK_EQ(dem_contacts_get(w[1], cb, 8), 2);
            for (i = 0; i < 2; i++)
                CHECK(memcmp(&ca[i].force, &cb[i].force, sizeof ca[i].force) == 0);
            for (i = 0; i < 2; i++) scene_step(w[i], 20);
            CHECK_EQ(dem_world_hash_get(w[1]), dem_world_hash_get(w[0]));
            for (i = 0; i < 2; i++) dem_world_destroy(w[i]);
        }
        remove(path);
    }
    TEST("a checkpoint between dem_body_remove and the next step resumes with the same bits in a fresh and in a used "
         "world") {
        int fresh;
        for (fresh = 0; fresh < 2; fresh++) {
            dem_material stuff;
            dem_world *a = row_world(0.3, &stuff), *b = row_world(0.3, &stuff);
            row_add(a, stuff);
            scene_step(a, 1);
            if (!fresh) {
                row_add(b, stuff);
                scene_step(b, 2);
            }
            CHECK_EQ(dem_body_remove(a, dem_body_id_get(a, 1)), DEM_OK);
            CHECK_EQ(dem_checkpoint_write(a, path), DEM_OK);
            CHECK_EQ(dem_checkpoint_read(b, path), DEM_OK);
            CHECK_EQ(dem_world_hash_get(a), dem_world_hash_get(b));
            CHECK_EQ(dem_body_counts_get(b).removed, 1);
            dem_sphere_add(a, stuff, DEM_R(1e-3), at(0, 1.99e-3, 0));    /* takes the same slot */
            dem_sphere_add(b, stuff, DEM_R(1e-3), at(0, 1.99e-3, 0));
            scene_step(a, 20);
            scene_step(b, 20);
            CHECK_EQ(dem_world_hash_get(a), dem_world_hash_get(b));
            dem_world_destroy(a);
            dem_world_destroy(b);
        }
        remove(path);
    }
    TEST("reading a checkpoint removes a wall that was removed before it; a wall removed here but present there is "
         "rejected") {
        dem_world *a = other_world(SAME), *b = other_world(SAME);
        dem_wall wall;
        dem_pose pose;
        wall.id = 2;
        CHECK_EQ(dem_checkpoint_write(a, path), DEM_OK);
        CHECK_EQ(dem_wall_remove(a, wall), DEM_OK);
        refused(a, DEM_ERROR_FORMAT, "wall 2 was removed here");
        CHECK_EQ(dem_checkpoint_write(a, path), DEM_OK);
        CHECK_EQ(dem_checkpoint_read(a, path), DEM_OK);
        CHECK_EQ(dem_wall_pose_get(b, wall, &pose), DEM_OK);
        CHECK_EQ(dem_checkpoint_read(b, path), DEM_OK);
        CHECK_EQ(dem_wall_pose_get(b, wall, &pose), DEM_ERROR_ARGUMENT);
        CHECK_EQ(dem_world_hash_get(a), dem_world_hash_get(b));
        dem_world_destroy(a);
        dem_world_destroy(b);
        remove(path);
    }
    TEST("the error for another scene names the field that differs, its part and both values") {
        static const char *parts[] = {"", "density 2500 of material 1, this world has 2501",
            "tangent_damping 1 (dem_pair_set) of materials 1 and 1, this world has 0.5",
            "gravity.z -9.81, this world has -9.8", "integrator velocity_verlet, this world has leapfrog",
            "the checkpoint has 4 walls, this world 3", "other elements of wall 1 than", "share 1 of wall 2, this world has 0.5",
            "motion.kind oscillating of wall 1, this world has translating",
            "box.hi.x 1 of field 1, this world has 2", "cells[0] 2 of field 1, this world has 3",
            "kind profile of wall 3, this world has segments"};
        dem_world *world = other_world(SAME), *other = other_world(WALL_MORE);
        int what;
        CHECK_EQ(dem_checkpoint_write(world, path), DEM_OK);
        for (what = DENSITY; what < OTHERS; what++) {
            dem_world *here = other_world(what);
            if (what != WALL_MORE) refused(here, DEM_ERROR_FORMAT, parts[what]);
            dem_world_destroy(here);
        }
        CHECK_EQ(dem_checkpoint_write(other, path), DEM_OK);
        refused(world, DEM_ERROR_FORMAT, parts[WALL_MORE]);
        dem_world_destroy(world);
        dem_world_destroy(other);
        remove(path);
    }
    TEST("each of 79 false values with a correct checksum is rejected with its name and leaves the world unchanged") {
        int lie, told = 0;
        for (lie = 0; lie < 110; lie++) {
            const int before = test_now.wrong;
            dem_world *liar = rich_world(20), *world = rich_world(20);
            if (lie >= 100) CHECK(demi_list_drop(liar));
            if (lie_write(liar, lie)) {
                told++;
                refused(world, DEM_ERROR_FORMAT, ": invalid ");
                CHECK_EQ(scene_step(world, 5), DEM_OK);
            }
            if (test_now.wrong > before) printf("        with lie %d\n", lie);
            dem_world_destroy(liar);
            dem_world_destroy(world);
        }
        CHECK_EQ(told, 79);
        remove(path);
    }
    TEST("every number of a world with a range is rejected if it is NaN, also with a correct checksum") {
        int row, told = 0;
        for (row = 0; demi_number_rows[row].name; row++) {
            dem_world *liar = rich_world(20), *world = rich_world(20);
            if (lie_write(liar, 200 + row)) {
                told++;
                refused(world, DEM_ERROR_FORMAT, ": invalid ");
            }
            if (test_now.wrong) printf("        %s\n", demi_number_rows[row].name);
            dem_world_destroy(liar);
            dem_world_destroy(world);
            if (test_now.wrong) break;
        }
        CHECK(told > 15);
        remove(path);
    }
    TEST("a checkpoint that cannot be written leaves the older file intact and reports why") {
        char longest[300] = "build/tmp/";
        dem_world *world = tiny_world(2500);
        const uint64_t hash = dem_world_hash_get(world);
        size_t before, after;
        char *old, *present;
        CHECK_EQ(dem_checkpoint_write(world, "build/tmp/no such folder/a.ckpt"), DEM_ERROR_FILE);
        CHECK_STR(dem_world_error_get(world), "dem_checkpoint_write: ");
        CHECK_STR(dem_world_error_get(world), "no such folder");
        CHECK_EQ(dem_checkpoint_write(world, 0), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "path is null");
        /* a name as long as file systems take: the temporary one, 4 longer, cannot be opened */
        memset(longest + 10, 'n', 253);
        CHECK_EQ(dem_checkpoint_write(world, path), DEM_OK);
        CHECK_EQ(rename(path, longest), 0);
        old = file_get(longest, &before);
        scene_step(world, 3);
        CHECK_EQ(dem_checkpoint_write(world, longest), DEM_ERROR_FILE);
        present = file_get(longest, &after);
        CHECK_EQ(before, after);
        CHECK(old && present && memcmp(old, present, after) == 0);
        CHECK_EQ(dem_checkpoint_read(world, longest), DEM_OK);
        CHECK_EQ(dem_world_hash_get(world), hash);
        remove(longest);
        free(old);
        free(present);
        dem_world_destroy(world);
    }
    TEST("a run that has blown up does not overwrite its last checkpoint, and the error message says so") {
        dem_world *world = tiny_world(2500);
        size_t before, after;
        char *old, *present;
        scene_step(world, 3);
        CHECK_EQ(dem_checkpoint_write(world, path), DEM_OK);
        old = file_get(path, &before);
        world->bodies.vel[1] = (dem_real)(HUGE_VAL - HUGE_VAL);
        CHECK_EQ(dem_checkpoint_write(world, path), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "the run has blown up");
        present = file_get(path, &after);
        CHECK_EQ(before, after);
        CHECK(old && present && memcmp(old, present, after) == 0);
        CHECK_EQ(dem_checkpoint_read(world, path), DEM_OK);
        CHECK_EQ(scene_step(world, 3), DEM_OK);
        free(old);
        free(present);
        dem_world_destroy(world);
    }
    TEST("a checkpoint is read after a worn mesh or profile was removed while contacts are recorded") {
        int flat, later;
        for (flat = 0; flat < 2; flat++) {
            dem_world *w[2];                   /* removes the wall; still has it */
            dem_wall ground = {0};
            dem_wear wear;
            dem_events_desc record = DEM_EVENTS_DESC;
            int k;
            for (k = 0; k < 2; k++) {
                static const dem_real ends[4] = {DEM_R(-0.1), 0, DEM_R(0.1), 0};
                static const int32_t segment[2] = {0, 1};
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_profile line;
                dem_material glass;
                desc.threads = 1;
                desc.dt = DEM_R(1e-5);
                desc.ledger = 1;
                desc.planar = flat;
                desc.gravity = flat ? at(1, -9.81, 0) : at(1, 0, -9.81);
                w[k] = dem_world_create(&desc);
                glass = scene_material(w[k], 1e7, 0.5, 0.3, 0);
                line.vertex_count = 2;
                line.segment_count = 1;
                line.vertices = (dem_real *)ends;
                line.segments = (int32_t *)segment;
                ground = flat ? dem_wall_profile_add(w[k], glass, &line, DEM_EDGE_RESOLVED)
                    : scene_floor(w[k], glass, -0.1, -0.1, 0.1, 0.1, 1, 1);
                scene_move(w[k], dem_sphere_add(w[k], glass, DEM_R(0.005), at(0, flat*0.00499, (1 - flat)*0.00499)),
                           at(0.5, 0, 0), at(0, 0, 0));          /* slides */
            }
            CHECK_EQ(dem_events_record(w[0], &record), DEM_OK);
            CHECK_EQ(scene_step(w[0], 100), DEM_OK);
            CHECK_EQ(dem_wall_wear_get(w[0], ground, 1, 1, &wear), DEM_OK);
            CHECK(wear.slide > 0);
            CHECK_EQ(dem_wall_remove(w[0], ground), DEM_OK);
            for (later = 0; later < 2; later++) {
                dem_effect effects[DEM_EFFECTS];
                CHECK_EQ(dem_checkpoint_write(w[0], path), DEM_OK);
                for (k = 1; k >= 0; k--) {
                    CHECK_EQ(dem_checkpoint_read(w[k], path), DEM_OK);
                    if (test_now.wrong) puts(dem_world_error_get(w[k]));
                    CHECK_EQ(dem_world_hash_get(w[k]), dem_world_hash_get(w[0]));
                }
                CHECK_EQ(dem_effects_get(w[0], 1e-9, effects), DEM_EFFECTS);     /* by such copies */
                CHECK_EQ(scene_step(w[0], 50), DEM_OK);
            }
            for (k = 0; k < 2; k++) dem_world_destroy(w[k]);
        }
        remove(path);
    }
    TEST("impulses: a joint to an oscillating wall resumes with the same bits while radii grow") {
        dem_world *w[2];
        int k, i;
        for (k = 0; k < 2; k++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_joint_desc joint = DEM_JOINT_DESC;
            dem_motion motion = DEM_MOTION;
            dem_material glass;
            desc.response = DEM_RESPONSE_IMPULSES;
            desc.orientations = 1;
            desc.dt = DEM_R(2e-4);
            desc.growth = larger;
            w[k] = dem_world_create(&desc);
            glass = scene_material(w[k], 1e7, 0.5, 0.3, 0);
            joint.kind = DEM_JOINT_POINT;
            joint.a = dem_sphere_add(w[k], glass, DEM_R(1e-3), at(0, 0, 0));
            joint.point = at(3e-4, 0, 0);
            joint.wall = dem_wall_plane_add(w[k], glass, at(0, 0, -1), at(0, 0, 1));
            motion.kind = DEM_MOTION_OSCILLATING;
            motion.velocity = at(0, 0, 1);
            motion.amplitude = DEM_R(2e-4);
            motion.frequency = 50;
            CHECK_EQ(dem_wall_motion_set(w[k], joint.wall, &motion), DEM_OK);
            CHECK(dem_joint_add(w[k], &joint).id > 0);
        }
        CHECK_EQ(scene_step(w[0], 1), DEM_OK);
        CHECK_EQ(dem_checkpoint_write(w[0], path), DEM_OK);
        CHECK_EQ(dem_checkpoint_read(w[1], path), DEM_OK);
        for (i = 0; i < 20; i++) {
            for (k = 0; k < 2; k++) CHECK_EQ(scene_step(w[k], 1), DEM_OK);
            CHECK_EQ(dem_world_hash_get(w[1]), dem_world_hash_get(w[0]));
        }
        for (k = 0; k < 2; k++) dem_world_destroy(w[k]);
        remove(path);
    }
    return test_end();
}
