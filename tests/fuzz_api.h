/* fuzz_api.h - a machine that plays programs of public calls, to find the order of calls that breaks
   something. Include after dem.h (small DEM_DOMAIN_BODIES: many domains with few grains).

   A program is a string of bytes, four to a call: the kind, and a seed that all arguments are drawn from;
   the first four choose the world. So any bytes are a program, and a call can be dropped without changing
   the arguments of the others.

   Every call is made in two worlds, A on one thread and B on two. After each one, both must give the same
   answers, the same hash and the same looks (counters, loads, contacts in order, ...). Also demanded:
     - a call that is refused says why and leaves the hash as it was;
     - looking changes nothing (some looks are made in A alone, and the two go on together);
     - a checkpoint read back into its world, or into a fresh one with the same scene, gives the same hash
       and looks, and the same again over the steps that follow; the program then goes on in the fresh one;
     - memory refused at the k-th request leaves the hash as it was, and the call made again gives what B
       got; all memory goes back, with its right size. New memory is full of bytes that differ in A and B.
   A run that stops by name (unstable, time step) is an answer like any other. */
#ifndef FUZZ_API_H
#define FUZZ_API_H
#include "../examples/moldyn.h"
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What is left out until dem.h is mended. Set a switch to 0 to have it in. */
typedef struct fuzz_avoid {
    int null_arguments;               /* null worlds, descs and out pointers */
    int unusable_values;              /* radius 1e-310, rule 99, cluster mass 55, negative counts, ... */
    int checkpoint_after_pairs;       /* written between dem_pair_set or dem_material_add and a rebuild */
    int checkpoint_after_remove;      /* read into a fresh world when bodies went since the last step */
    int slabs_in_one_world;           /* dem_slabs_create in A and not in B, where it should change nothing */
    int checkpoint_oriented_reader;   /* read by a world with orientations when the writer had none */
    int stale_domains;                /* sums of domains that were in use once, and not at the last step */
    int step_refused_after_feed;      /* a step that is refused when feeds have put in grains */
    int slabs_collect_changed;        /* into a world whose grains came or went since dem_slabs_create */
    int memory_refused;               /* the k-th request gets nothing */
    int memory_refused_hash;          /* ... and the hash is as it was */
    int going_on_after_unstable;      /* calls after a run that stopped as unstable: then the program ends */
} fuzz_avoid;
static fuzz_avoid fuzz_avoids = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
static const char *fuzz_folder = "build/tmp";  /* for files */

enum { FUZZ_CALLS = 64, FUZZ_WALLS = 32, FUZZ_BYTES = 4*(FUZZ_CALLS + 1), FUZZ_CONTACTS = 4096 };

/* ---- memory that counts and can refuse ---- */
typedef struct fuzz_memory {
    long live, refuse;                /* blocks out; requests until one gets nothing, 0: never */
    int refused, wrong;               /* one got nothing; a block came back with another size */
    unsigned char fill;
} fuzz_memory;
static void *fuzz_alloc(size_t size, void *user) {
    fuzz_memory *m = (fuzz_memory *)user;
    char *p;
    if (m->refuse > 0 && --m->refuse == 0) { m->refused = 1; return 0; }
    p = (char *)malloc(size + 32);
    if (!p) return 0;
    memcpy(p, &size, sizeof size);
    memset(p + 32, m->fill, size);
    m->live++;
    return p + 32;
}
static void fuzz_free(void *memory, size_t size, void *user) {
    fuzz_memory *m = (fuzz_memory *)user;
    size_t was;
    memcpy(&was, (char *)memory - 32, sizeof was);
    m->wrong += was != size;
    m->live--;
    memset((char *)memory - 32, 0x5a, was + 32);
    free((char *)memory - 32);
}

/* ---- a world and what the program knows of it ---- */
typedef struct fuzz_machine {
    dem_world *world;
    dem_slabs *slabs;
    fuzz_memory *memory;
    char name;                        /* 'A', 'B'; 'F': the fresh one */
    uint32_t desc_seed;
    int materials, shapes, feeds, outlets, fields, joints;         /* ids run from 1 */
    int walls, wall[FUZZ_WALLS];                                   /* the last ids given */
    int impulses;                     /* contacts answer by them */
    int scene, bodies_gone, pairs_new;   /* scene: its version; what changed since the last step */
    int saved, saved_scene;           /* a file is there; the version it was written from */
    uint64_t saved_hash;
    dem_body_counts dealt;                /* when slabs were created */
    /* of the call under way */
    uint64_t random, answer, before, rebuilds;
    int failed, refusable;            /* 1: refused; 1: then the hash must be as before */
    int must_fail;                    /* 1: a bad call, to be refused */
    int unstable;                     /* a run stopped so */
    int domains_most;                 /* ever in use */
    int printing;
} fuzz_machine;

static char fuzz_wrong[1000];         /* what went wrong first */
static void fuzz_fail(const char *format, ...) {
    va_list list;
    if (fuzz_wrong[0]) return;
    va_start(list, format);
    vsnprintf(fuzz_wrong, sizeof fuzz_wrong, format, list);
    va_end(list);
}

static uint64_t fuzz_next(uint64_t *state) {
    uint64_t z = (*state += UINT64_C(0x9E3779B97F4A7C15));
    z = (z ^ (z >> 30))*UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27))*UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31);
}
static int fuzz_below(fuzz_machine *m, int n) { return n > 0 ? (int)(fuzz_next(&m->random)%(uint64_t)n) : 0; }
static dem_real fuzz_real(fuzz_machine *m, double lo, double hi) {
    return (dem_real)(lo + (hi - lo)*(double)(fuzz_next(&m->random) >> 11)/9007199254740992.0);
}
static dem_vec3 fuzz_vector(fuzz_machine *m, double lo, double hi) {
    const dem_real x = fuzz_real(m, lo, hi), y = fuzz_real(m, lo, hi), z = fuzz_real(m, lo, hi);
    return dem_vec3_make(x, y, z);
}
static dem_quat fuzz_turn(fuzz_machine *m) {
    const dem_vec3 v = fuzz_vector(m, -1, 1);
    return dem_quat_make(fuzz_real(m, 0.1, 1), v.x, v.y, v.z);
}
/* A number that no call should take, or 0 and -1, which few do. */
static dem_real fuzz_bad(fuzz_machine *m) {
    switch (fuzz_below(m, 4)) {
    case 0: return (dem_real)NAN;
    case 1: return (dem_real)INFINITY;
    case 2: return DEM_R(-1);
    default: return 0;
    }
}
static dem_material fuzz_material(fuzz_machine *m) {
    dem_material id;
    id.id = 1 + fuzz_below(m, m->materials);
    return id;
}
static dem_wall fuzz_wall(fuzz_machine *m) {
    dem_wall id;
    id.id = m->walls ? m->wall[fuzz_below(m, m->walls)] : 1;
    return id;
}
static dem_body fuzz_body(fuzz_machine *m) {
    const dem_bodies all = dem_bodies_get(m->world);
    dem_body none;
    none.slot = none.generation = 0;
    if (!all.count) return none;
    return dem_body_id_get(m->world, fuzz_below(m, all.count));
}

static void fuzz_say(fuzz_machine *m, const char *format, ...) {
    va_list list;
    if (!m->printing) return;
    va_start(list, format);
    vprintf(format, list);
    va_end(list);
    fflush(stdout);
}
static void fuzz_say_vector(fuzz_machine *m, const char *what, dem_vec3 v) {
    fuzz_say(m, " %s (%.9g, %.9g, %.9g)", what, (double)v.x, (double)v.y, (double)v.z);
}
static uint64_t fuzz_hash(uint64_t h, const void *data, size_t size) {
    const unsigned char *p = (const unsigned char *)data;
    size_t i;
    for (i = 0; i < size; i++) h = (h ^ p[i])*UINT64_C(1099511628211);
    return h;
}
static void fuzz_note(fuzz_machine *m, const void *data, size_t size) {
    m->answer = fuzz_hash(m->answer, data, size);
}
static void fuzz_note_int(fuzz_machine *m, int i) { fuzz_note(m, &i, sizeof i); }
static void fuzz_note_real(fuzz_machine *m, double d) { fuzz_note(m, &d, sizeof d); }
static void fuzz_note_vector(fuzz_machine *m, dem_vec3 v) {
    fuzz_note_real(m, (double)v.x); fuzz_note_real(m, (double)v.y); fuzz_note_real(m, (double)v.z);
}
static void fuzz_refused(fuzz_machine *m, const char *error) {
    m->failed = 1;
    m->refusable = 1;
    fuzz_say(m, " -> refused: %s", error);
    if (!*error) fuzz_fail("%c: refused without a sentence", m->name);
    for (; *error; error++)                      /* the names of A's and B's files count as one */
        if (!strncmp(error, "api_", 4)) error += 4; else fuzz_note(m, error, 1);
}
static int fuzz_result(fuzz_machine *m, dem_result r) {              /* 1: ok */
    fuzz_note_int(m, (int)r);
    if (r != DEM_OK) fuzz_refused(m, dem_world_error_get(m->world));
    return r == DEM_OK;
}
static int fuzz_id(fuzz_machine *m, int32_t id) {
    fuzz_note_int(m, id);
    if (!id) fuzz_refused(m, dem_world_error_get(m->world));
    else fuzz_say(m, " -> %d", (int)id);
    return id != 0;
}
/* The bytes of a file join the answer. */
static void fuzz_note_file(fuzz_machine *m, const char *path) {
    char some[4096];
    FILE *f = fopen(path, "rb");
    size_t n;
    if (!f) { fuzz_note_int(m, -1); return; }
    while ((n = fread(some, 1, sizeof some, f)) > 0) fuzz_note(m, some, n);
    fclose(f);
}
static const char *fuzz_path(const char *name, char who, char *out) {
    snprintf(out, 200, "%s/api_%c%s", fuzz_folder, who, name);
    return out;
}

/* ---- laws, fields, motions of one's own; each now and then tries to change the world that calls it ---- */
static dem_world *fuzz_calling;                 /* null: nobody knows who calls */
static int fuzz_intrusions;
static void fuzz_intrude(void) {
    dem_world *w = fuzz_calling;
    dem_body_state state;
    dem_wall wall;
    int what;
    if (!w) return;
#ifdef _OPENMP
    #pragma omp critical(fuzz_intrude)
#endif
    what = ++fuzz_intrusions;
    if (what%17) return;
    memset(&state, 0, sizeof state);
    wall.id = 1;
    what = what/17%9;
    if ((what == 0 && dem_body_remove(w, dem_body_id_get(w, 0)) == DEM_OK) ||
        (what == 1 && dem_world_gravity_set(w, dem_vec3_make(1, 2, 3)) == DEM_OK) ||
        (what == 2 && dem_candidates_rebuild(w) == DEM_OK) || (what == 3 && dem_wall_remove(w, wall) == DEM_OK) ||
        (what == 4 && dem_world_step(w, 1) == DEM_OK) || (what == 5 && dem_checkpoint_read(w, "none") == DEM_OK) ||
        (what == 6 && dem_body_set(w, dem_body_id_get(w, 0), &state) == DEM_OK) ||
        (what == 7 && dem_world_run(w, 1e-5, 0, 0) == DEM_OK)) fuzz_fail("a function of the user's changed the world, way %d", what);
    if (what == 8) dem_world_destroy(w);
}
static double fuzz_number(const dem_world *w, dem_body body, void *user) {
    (void)user;
    fuzz_intrude();
    return body.slot%7 ? (double)body.slot + dem_world_time_get(w) : (double)NAN;
}
static void fuzz_values(const dem_world *w, double *values, void *user) {
    (void)user;
    fuzz_intrude();
    values[0] = dem_totals_get(w).kinetic;
}
/* The function of an output may change the world, but not step or destroy it. */
static int fuzz_output_call(dem_world *w, int64_t number, void *user) {
    (void)user;
    if (dem_world_step(w, 1) == DEM_OK) fuzz_fail("a step within an output");
    dem_world_destroy(w);
    return number < 0;
}
static void fuzz_reals(dem_real *reals, const dem_real *rates, const dem_body_state *body, dem_body id, double time, dem_real dt,
                       void *user) {
    (void)time; (void)user;
    fuzz_intrude();
    reals[0] += dt*(rates[0] + body->velocity.x);
    reals[1] = (dem_real)id.slot;
}
static void fuzz_law(const dem_contact *c, dem_real *memory, dem_contact_force *push) {
    const dem_real k = DEM_R(2e3);
    dem_vec3 xi = dem_memory_rotate(c, dem_vec3_make(memory[0], memory[1], memory[2]));
    xi = dem_vec3_make(xi.x + c->slip_step.x*c->dt, xi.y + c->slip_step.y*c->dt,
                       xi.z + c->slip_step.z*c->dt);
    fuzz_intrude();
    push->normal = k*c->overlap + DEM_R(0.01)*c->closing_speed;
    push->tangent = dem_vec3_make(-k*xi.x/4, -k*xi.y/4, -k*xi.z/4);
    if (c->dt > 0) {
        memory[0] = xi.x; memory[1] = xi.y; memory[2] = xi.z;
        memory[3] = c->overlap > memory[3] ? c->overlap : memory[3];
    }
}
static dem_vec3 fuzz_force(dem_vec3 x, dem_vec3 v, dem_real radius, dem_real mass, double time, void *user) {
    (void)radius; (void)user;
    fuzz_intrude();
    return dem_vec3_make(mass*(DEM_R(0.015) - x.x)*100 - mass*v.x, mass*(dem_real)time, -mass*v.z);
}
static void fuzz_motion(double time, dem_pose *pose, void *user) {
    const double a = 2e-4, w = 600;
    (void)user;
    fuzz_intrude();
    memset(pose, 0, sizeof *pose);
    pose->rotation[0] = pose->rotation[4] = pose->rotation[8] = 1;
    pose->position.z = (dem_real)(a*sin(w*time));
    pose->velocity.z = (dem_real)(a*w*cos(w*time));
}
static int fuzz_inside(dem_vec3 x, dem_real radius, void *user) {
    (void)radius; (void)user;
    fuzz_intrude();
    return x.x + x.y < DEM_R(0.034);
}
static int fuzz_progress(const dem_world *world, double done, double left, void *user) {
    (void)world; (void)done; (void)left; (void)user;
    fuzz_intrude();
    return 0;                                   /* called by wall time: must not steer */
}

/* ---- the scene: grains in the middle of a box of 30 mm, walls about them ---- */
static const double fuzz_lo = 0.006, fuzz_hi = 0.024, fuzz_all = 0.03;

static dem_world_desc fuzz_desc(fuzz_machine *m, int threads) {
    dem_world_desc d = DEM_WORLD_DESC;
    int k;
    if (fuzz_below(m, 4)) d.gravity.z = DEM_R(-9.81);
    if (!fuzz_below(m, 4)) d.gravity.x = 30;
    d.domain.hi = dem_vec3_make((dem_real)fuzz_all, (dem_real)fuzz_all, (dem_real)fuzz_all);
    if (!fuzz_below(m, 3)) d.domain = dem_box_make((dem_real)fuzz_lo, (dem_real)fuzz_lo, (dem_real)fuzz_lo,
                                                   (dem_real)fuzz_hi, (dem_real)fuzz_hi, (dem_real)fuzz_hi);
    d.planar = !fuzz_below(m, 10);
    for (k = 0; k < (d.planar ? 2 : 3); k++)
        if (!fuzz_below(m, 3)) d.boundary[k] = (dem_boundary)(1 + (fuzz_below(m, 3) == 0));
    d.normal_law = (dem_normal_law)fuzz_below(m, 3);
    d.tangent_law = (dem_tangent_law)fuzz_below(m, 7);
    d.rolling_law = (dem_rolling_law)fuzz_below(m, 5);
    if (!fuzz_below(m, 3)) { d.tangent_law = DEM_TANGENT_AUTO; d.rolling_law = DEM_ROLLING_AUTO; }
    d.tension = (dem_tension)fuzz_below(m, 2);
    d.convention = (dem_convention)(fuzz_below(m, 8) == 0);
    if (!fuzz_below(m, 8)) {
        d.law = fuzz_law;
        d.law_memory = 4;
        d.law_vectors = 1;
        d.law_stiffness = DEM_R(2e3);
    }
    if (!fuzz_below(m, 6)) d.force = fuzz_force;
    if (!fuzz_below(m, 5)) {
        d.body_reals = "heat number";
        if (fuzz_below(m, 2)) d.body_reals_fn = fuzz_reals;
    }
    d.integrator = (dem_integrator)fuzz_below(m, 5);
    if (!fuzz_below(m, 4)) d.dt = DEM_R(4e-6);
    d.allow_large_dt = !fuzz_below(m, 6);
    if (fuzz_below(m, 2)) d.impact_speed = 1;
    d.search = (dem_search)fuzz_below(m, 6);
    if (!fuzz_below(m, 3)) d.skin = fuzz_below(m, 3) ? DEM_R(3e-4) : DEM_R(-1);
    d.rotation = (dem_rotation)fuzz_below(m, 3);
    d.ellipsoid_overlap = (dem_overlap)fuzz_below(m, 3);
    d.cluster_contacts = (dem_cluster_contacts)fuzz_below(m, 2);
    d.orientations = !fuzz_below(m, 4);
    d.ledger = fuzz_below(m, 2);
    d.threads = threads;
    if (!fuzz_below(m, 3)) {
        d.response = DEM_RESPONSE_IMPULSES;
        d.solver = (dem_solver)(fuzz_below(m, 2) ? 0 : fuzz_below(m, 4));
        d.cone = (dem_cone)fuzz_below(m, 2);
        d.dt = fuzz_below(m, 2) ? DEM_R(1e-4) : DEM_R(5e-4);
        if (fuzz_below(m, 2)) d.tolerance = DEM_R(1e-6);
        if (!fuzz_below(m, 3)) d.sweeps = 1 + fuzz_below(m, 30);
        d.cold_start = !fuzz_below(m, 3);
        if (!fuzz_below(m, 4)) d.law_range = DEM_R(3e-4);
        if (fuzz_below(m, 2)) d.orientations = 1;
        d.integrator = (dem_integrator)0;
        d.law = 0;
        d.law_memory = d.law_vectors = 0;
        d.law_stiffness = 0;
    }
    if (d.planar && fuzz_below(m, 2)) d.thickness = DEM_R(1e-3);
    d.allocator.alloc_fn = fuzz_alloc;
    d.allocator.free_fn = fuzz_free;
    d.allocator.user = m->memory;
    return d;
}
static void fuzz_open(fuzz_machine *m, uint32_t seed, int threads) {
    dem_world_desc d;
    m->random = m->desc_seed = seed;
    d = fuzz_desc(m, threads);
    m->impulses = d.response == DEM_RESPONSE_IMPULSES;
    m->world = dem_world_create(&d);
    if (!m->world) { fuzz_fail("%c: no world: %s", m->name, dem_world_create_error_get(&d)); return; }
    fuzz_say(m, "world: threads %d, gravity (%g 0 %g), domain %g..%g, boundary %d %d %d, planar %d, laws %d %d %d, "
             "tension %d, convention %d, own law %d, own force %d, integrator %d, dt %g, large %d, impact %g, "
             "search %d, skin %g, rotation %d, overlap %d, sharing %d, orientations %d, ledger %d, impulses %d, "
             "solver %d, cone %d, sweeps %d, tolerance %g, cold %d, range %g\n", threads,
             (double)d.gravity.x, (double)d.gravity.z, (double)d.domain.lo.x, (double)d.domain.hi.x,
             (int)d.boundary[0], (int)d.boundary[1], (int)d.boundary[2], d.planar, (int)d.normal_law,
             (int)d.tangent_law, (int)d.rolling_law, (int)d.tension, (int)d.convention, d.law != 0,
             d.force != 0, (int)d.integrator, (double)d.dt, d.allow_large_dt, (double)d.impact_speed,
             (int)d.search, (double)d.skin, (int)d.rotation, (int)d.ellipsoid_overlap,
             (int)d.cluster_contacts, d.orientations, d.ledger, m->impulses, (int)d.solver, (int)d.cone, d.sweeps,
             (double)d.tolerance, d.cold_start, (double)d.law_range);
}

/* ---- calls: materials and shapes ---- */
static void fuzz_material_add(fuzz_machine *m) {
    dem_material_desc d = DEM_MATERIAL_DESC;
    d.density = fuzz_real(m, 500, 5000);
    d.young = fuzz_real(m, 1e6, 1e7);
    d.poisson = fuzz_below(m, 3) ? DEM_R(0.25) : 0;
    d.restitution = fuzz_real(m, 0.3, 1);
    if (fuzz_below(m, 2)) d.friction = fuzz_real(m, 0, 1);
    if (fuzz_below(m, 2)) d.friction_static = d.friction*fuzz_real(m, 1, 2);
    if (fuzz_below(m, 2)) d.rolling_friction = fuzz_real(m, 0, 0.3);
    if (!fuzz_below(m, 3)) d.stiffness = fuzz_real(m, 1e3, 1e4);
    if (!fuzz_below(m, 3)) d.stiffness_adhesion = fuzz_real(m, 0, 200);
    fuzz_say(m, "dem_material_add: density %g young %g nu %g e %g mu %g static %g rolling %g stiffness %g adhesion %g",
             (double)d.density, (double)d.young, (double)d.poisson, (double)d.restitution, (double)d.friction,
             (double)d.friction_static, (double)d.rolling_friction, (double)d.stiffness,
             (double)d.stiffness_adhesion);
    if (fuzz_id(m, dem_material_add(m->world, &d).id)) { m->materials++; m->pairs_new = 1; }
}
static void fuzz_pair_set(fuzz_machine *m) {
    const dem_material a = fuzz_material(m), b = fuzz_material(m);
    dem_pair p;
    const int what = fuzz_below(m, m->impulses ? 9 : 6);
    memset(&p, 0, sizeof p);
    if (!fuzz_result(m, dem_pair_get(m->world, a, b, &p))) return;
    if (what == 0) p.friction = p.friction_static = fuzz_real(m, 0, 1);
    if (what == 1) p.friction = p.friction_static = 0;
    if (what == 2) p.rolling_friction = fuzz_below(m, 2) ? DEM_R(0.1) : 0;
    if (what == 3) p.restitution = fuzz_real(m, 0.3, 1);
    if (what == 4) p.tangent_damping = fuzz_real(m, 0, 2);
    if (what == 5) p.young_eff *= fuzz_real(m, 0.7, 1.5);
    if (what == 6) p.spinning_friction = fuzz_real(m, 0, 0.3);
    if (what == 7) p.cohesion = fuzz_real(m, 0, 1e-3);
    if (what == 8) p.compliance = fuzz_real(m, 0, 1e-3);
    fuzz_say(m, "dem_pair_set %d %d: friction %g, rolling %g, e %g, damping %g, E* %g", (int)a.id, (int)b.id,
             (double)p.friction, (double)p.rolling_friction, (double)p.restitution, (double)p.tangent_damping,
             (double)p.young_eff);
    if (fuzz_result(m, dem_pair_set(m->world, a, b, &p))) m->pairs_new = 1;
}
static void fuzz_ellipsoid(fuzz_machine *m) {
    dem_vec3 a = fuzz_vector(m, 4e-4, 1.5e-3);
    if (!fuzz_below(m, 3)) a.y = a.x;
    if (!fuzz_below(m, 6)) a.y = a.z = a.x;
    fuzz_say_vector(m, "dem_shape_ellipsoid_add", a);
    if (fuzz_id(m, dem_shape_ellipsoid_add(m->world, a).id)) m->shapes++;
}
static void fuzz_cluster(fuzz_machine *m) {
    dem_cluster_desc d = DEM_CLUSTER_DESC;
    dem_real x[3*6], r[6];
    int i;
    d.count = 1 + fuzz_below(m, 6);
    d.positions = x;
    d.radii = fuzz_below(m, 2) ? r : 0;
    d.radius = fuzz_real(m, 5e-4, 8e-4);
    d.mass = fuzz_below(m, 2) ? DEM_CLUSTER_SUM : DEM_CLUSTER_UNION;
    d.rays = 32;
    for (i = 0; i < d.count; i++) {
        const dem_vec3 v = fuzz_vector(m, -1e-3, 1e-3);
        x[3*i] = v.x; x[3*i + 1] = v.y; x[3*i + 2] = v.z;
        r[i] = fuzz_real(m, 4e-4, 8e-4);
    }
    fuzz_say(m, "dem_shape_cluster_add: %d spheres, mass %d", d.count, (int)d.mass);
    if (fuzz_id(m, dem_shape_cluster_add(m->world, &d).id)) m->shapes++;
}
/* The hull of points in a box, some of them in one plane, or twice at one place. */
static void fuzz_polyhedron(fuzz_machine *m) {
    dem_real x[3*24];
    const int n = 4 + fuzz_below(m, 21), how = fuzz_below(m, 4);
    int i;
    for (i = 0; i < n; i++) {
        const dem_vec3 v = fuzz_vector(m, -1e-3, 1e-3);
        x[3*i] = v.x; x[3*i + 1] = v.y; x[3*i + 2] = how == 1 && i%2 ? DEM_R(-1e-3) : v.z;
        if (how == 2 && i > 3 && i%3 == 0) memcpy(x + 3*i, x + 3*(i - 2), 3*sizeof *x);
    }
    fuzz_say(m, "dem_shape_polyhedron_add: %d points, %d", n, how);
    if (fuzz_id(m, dem_shape_polyhedron_add(m->world, n, x).id)) m->shapes++;
}
static dem_shape fuzz_shape(fuzz_machine *m) {
    dem_shape id;
    id.id = m->shapes ? 1 + fuzz_below(m, m->shapes) : 1;
    return id;
}
/* Several shapes as one; refused where one is a cluster or a union. */
static void fuzz_union(fuzz_machine *m) {
    dem_shape which[5];
    dem_real x[3*5], q[4*5];
    const int n = 1 + fuzz_below(m, 5), turned = fuzz_below(m, 2), flat = fuzz_below(m, 3);
    int i;
    for (i = 0; i < n; i++) {
        const dem_vec3 v = fuzz_vector(m, -8e-4, 8e-4);
        const dem_quat t = fuzz_turn(m);
        which[i] = fuzz_shape(m);
        x[3*i] = v.x; x[3*i + 1] = v.y; x[3*i + 2] = flat ? v.z : 0;
        q[4*i] = t.w; q[4*i + 1] = flat ? t.x : 0; q[4*i + 2] = flat ? t.y : 0; q[4*i + 3] = t.z;
    }
    fuzz_say(m, "dem_shape_union_add: %d shapes, turned %d, flat %d", n, turned, !flat);
    if (fuzz_id(m, dem_shape_union_add(m->world, n, which, x, turned ? q : 0).id)) m->shapes++;
}
/* A star, either way round, seldom one whose sides cross; its pieces are shapes, too. */
static void fuzz_polygon(fuzz_machine *m) {
    dem_real x[2*DEM_POLYHEDRON_FACES];
    const int n = 3 + fuzz_below(m, fuzz_below(m, 3) ? 10 : 98), back = fuzz_below(m, 2), how = fuzz_below(m, 5);
    dem_shape id;
    int i;
    for (i = 0; i < n; i++) {
        const double r = how == 1 ? 1e-3 : (double)fuzz_real(m, 3e-4, 1.2e-3);
        const double a = (back ? -1 : 1)*6.283185307179586*i/n;
        x[2*i] = (dem_real)(r*cos(a)); x[2*i + 1] = (dem_real)(r*sin(a));
        if (how == 2 && i && !fuzz_below(m, 8)) { x[2*i] = x[2*i - 2]; x[2*i + 1] = x[2*i - 1]; }
        if (how == 3) x[2*i] = fuzz_real(m, -1e-3, 1e-3);
    }
    fuzz_say(m, "dem_shape_polygon_add: %d points, back %d, %d", n, back, how);
    id = dem_shape_polygon_add(m->world, n, x);
    if (fuzz_id(m, id.id)) m->shapes = id.id;
}

/* ---- calls: walls ---- */
static void fuzz_wall_new(fuzz_machine *m, dem_wall id) {
    if (!fuzz_id(m, id.id)) return;
    if (m->walls == FUZZ_WALLS) memmove(m->wall, m->wall + 1, (size_t)--m->walls*sizeof *m->wall);
    m->wall[m->walls++] = id.id;
}
static void fuzz_plane(fuzz_machine *m) {
    const dem_material stuff = fuzz_material(m);
    const int axis = fuzz_below(m, 3), up = fuzz_below(m, 4) > 0;
    dem_real p[3] = {0, 0, 0}, n[3] = {0, 0, 0};
    p[axis] = (dem_real)(up ? fuzz_lo : fuzz_hi) + fuzz_real(m, -1e-4, 1e-4);
    n[axis] = up ? DEM_R(1) : DEM_R(-1);
    if (!fuzz_below(m, 4)) n[(axis + 1)%3] = fuzz_real(m, -0.05, 0.05);
    fuzz_say(m, "dem_wall_plane_add %d", (int)stuff.id);
    fuzz_say_vector(m, "point", dem_vec3_make(p[0], p[1], p[2]));
    fuzz_say_vector(m, "normal", dem_vec3_make(n[0], n[1], n[2]));
    fuzz_wall_new(m, dem_wall_plane_add(m->world, stuff, dem_vec3_make(p[0], p[1], p[2]),
                                   dem_vec3_make(n[0], n[1], n[2])));
}
static void fuzz_cylinder(fuzz_machine *m) {
    const dem_material stuff = fuzz_material(m);
    const int axis = fuzz_below(m, 3), inside = fuzz_below(m, 4) > 0;
    dem_real p[3], n[3] = {0, 0, 0};
    int k;
    n[axis] = 1;
    for (k = 0; k < 3; k++) p[k] = (dem_real)(inside ? fuzz_all/2 : fuzz_lo - 0.001);
    {
        const dem_real r = inside ? fuzz_real(m, 0.0125, 0.014) : fuzz_real(m, 1e-3, 1.5e-3);
        fuzz_say(m, "dem_wall_cylinder_add %d axis %d radius %.9g inside %d", (int)stuff.id, axis, (double)r, inside);
        fuzz_wall_new(m, dem_wall_cylinder_add(m->world, stuff, dem_vec3_make(p[0], p[1], p[2]),
                                          dem_vec3_make(n[0], n[1], n[2]), r, inside));
    }
}
static void fuzz_revolved(fuzz_machine *m) {
    const dem_material stuff = fuzz_material(m);
    const dem_vec3 mid = dem_vec3_make(DEM_R(0.015), DEM_R(0.015), DEM_R(0.004));
    const int n = 2 + fuzz_below(m, 4);
    dem_real radii[6], heights[6];
    int k;
    for (k = 0; k < n; k++) {
        radii[k] = fuzz_below(m, 5) ? fuzz_real(m, 0.009, 0.014) : 0;
        heights[k] = (dem_real)k*DEM_R(0.005);
    }
    fuzz_say(m, "dem_wall_revolved_add %d: %d rings", (int)stuff.id, n);
    if (n > 2) fuzz_wall_new(m, dem_wall_revolved_add(m->world, stuff, mid, dem_vec3_make(0, 0, 1), n, radii, heights));
    else fuzz_wall_new(m, dem_wall_cone_add(m->world, stuff, mid, dem_vec3_make(DEM_R(0.015), DEM_R(0.015), DEM_R(0.025)),
                                       radii[0], radii[1]));
}
static void fuzz_profile(fuzz_machine *m) {
    const dem_material stuff = fuzz_material(m);
    const int n = 3 + fuzz_below(m, 20);
    const dem_edge_rule rule = fuzz_below(m, 4) ? DEM_EDGE_RESOLVED : DEM_EDGE_FRACTION;
    const double r = 0.0135;
    dem_real v[2*32];
    int32_t s[2*32];
    dem_profile profile;
    int i;
    for (i = 0; i < n; i++) {
        v[2*i] = (dem_real)(fuzz_all/2 + r*cos(6.283185307179586*i/n));
        v[2*i + 1] = (dem_real)(fuzz_all/2 + r*sin(6.283185307179586*i/n));
        s[2*i] = i;
        s[2*i + 1] = (i + 1)%n;
    }
    profile.vertex_count = profile.segment_count = n;
    profile.vertices = v;
    profile.segments = s;
    fuzz_say(m, "dem_wall_profile_add %d: drum of %d segments, rule %d", (int)stuff.id, n, (int)rule);
    fuzz_wall_new(m, dem_wall_profile_add(m->world, stuff, &profile, rule));
}
static void fuzz_mesh(fuzz_machine *m) {
    const dem_material stuff = fuzz_material(m);
    const int n = 1 + fuzz_below(m, 8);
    const double bump = fuzz_below(m, 3) ? 0 : 5e-4, z = fuzz_lo - bump/2;
    dem_real v[3*81];
    int32_t t[3*128];
    dem_mesh mesh;
    int i, j, k = 0;
    for (j = 0; j <= n; j++)
        for (i = 0; i <= n; i++) {
            dem_real *p = v + 3*(i + (n + 1)*j);
            p[0] = (dem_real)(fuzz_all*i/n);
            p[1] = (dem_real)(fuzz_all*j/n);
            p[2] = (dem_real)(z + bump*(double)fuzz_real(m, 0, 1));
        }
    for (j = 0; j < n; j++)
        for (i = 0; i < n; i++) {
            const int32_t a = i + (n + 1)*j, b = a + 1, c = a + n + 1, d = c + 1;
            t[k++] = a; t[k++] = b; t[k++] = d;
            t[k++] = a; t[k++] = d; t[k++] = c;
        }
    mesh.vertex_count = (n + 1)*(n + 1);
    mesh.triangle_count = 2*n*n;
    mesh.vertices = v;
    mesh.triangles = t;
    fuzz_say(m, "dem_wall_mesh_add %d: floor of %d by %d, bumps %g", (int)stuff.id, n, n, bump);
    fuzz_wall_new(m, dem_wall_mesh_add(m->world, stuff, &mesh));
}
static void fuzz_grains_wall(fuzz_machine *m) {
    const dem_material stuff = fuzz_material(m);
    const int n = 1 + fuzz_below(m, 10);
    const double pitch = fuzz_all/n, r = pitch*0.6;
    dem_real x[300];
    int i;
    for (i = 0; i < n*n; i++) {
        x[3*i] = (dem_real)(pitch*(i%n + 0.5));
        x[3*i + 1] = (dem_real)(pitch*(i/n + 0.5));
        x[3*i + 2] = (dem_real)(fuzz_lo - r);
    }
    {
        const dem_real share = fuzz_below(m, 2) ? DEM_R(1) : fuzz_real(m, 0.1, 1);
        fuzz_say(m, "dem_wall_grains_add %d: %d by %d, radius %g, share %g", (int)stuff.id, n, n, r, (double)share);
        fuzz_wall_new(m, dem_wall_grains_add(m->world, stuff, n*n, x, (dem_real)r, share));
    }
}
static void fuzz_sieve(fuzz_machine *m) {
    const dem_material stuff = fuzz_material(m);
    dem_sieve_desc d = DEM_SIEVE_DESC;
    d.kind = (dem_sieve_kind)(1 + fuzz_below(m, 6));
    d.point = dem_vec3_make(DEM_R(0.015), DEM_R(0.015), (dem_real)(fuzz_lo - 2e-4));
    if (!fuzz_below(m, 3)) d.normal = dem_vec3_make(DEM_R(0.1), 0, 1);
    if (!fuzz_below(m, 3)) d.along = dem_vec3_make(1, 1, 0);
    d.aperture = fuzz_real(m, 5e-4, 2e-3);
    d.bar = fuzz_real(m, 3e-4, 1e-3);
    if (d.kind == DEM_SIEVE_SLOTS && fuzz_below(m, 2)) d.length = 3*d.aperture;
    if (d.kind > DEM_SIEVE_BARS && d.kind < DEM_SIEVE_REDUCED && fuzz_below(m, 2)) d.thickness = DEM_R(2e-4);
    if (d.kind == DEM_SIEVE_WIRES && fuzz_below(m, 2)) d.lift = d.bar;
    if (d.kind == DEM_SIEVE_ROUND) d.staggered = fuzz_below(m, 2);
    if (!fuzz_below(m, 3)) d.radius = DEM_R(0.012);
    if (d.kind == DEM_SIEVE_REDUCED) { d.model = fuzz_below(m, 3); d.clearance = fuzz_real(m, 0, 1); }
    fuzz_say(m, "dem_wall_sieve_add %d: kind %d, aperture %g, bar %g, radius %g", (int)stuff.id, (int)d.kind,
             (double)d.aperture, (double)d.bar, (double)d.radius);
    fuzz_wall_new(m, dem_wall_sieve_add(m->world, stuff, &d));
}
static void fuzz_wall_motion(fuzz_machine *m) {
    const dem_wall wall = fuzz_wall(m);
    dem_motion d = DEM_MOTION;
    dem_motion_row rows[4];
    int k;
    d.kind = (dem_motion_kind)fuzz_below(m, 7);
    memset(rows, 0, sizeof rows);
    for (k = 0; k < 4; k++) {
        rows[k].time = 1e-3*k;
        rows[k].position = k%2 ? fuzz_vector(m, -2e-4, 2e-4) : dem_vec3_make(0, 0, 0);
        rows[k].rotation = dem_quat_make(1, 0, k%2 ? DEM_R(0.01) : 0, 0);
    }
    d.table = rows;
    d.table_count = 4;
    d.table_repeats = fuzz_below(m, 2);
    if (fuzz_below(m, 2)) d.ramp = 1e-3;
    d.velocity = fuzz_vector(m, -0.1, 0.1);
    d.point = dem_vec3_make(DEM_R(0.015), DEM_R(0.015), DEM_R(0.015));
    if (fuzz_below(m, 2)) d.axis = dem_vec3_make(0, 0, 1);
    else d.axis = fuzz_vector(m, 0.1, 1);
    d.speed = fuzz_real(m, -10, 10);
    d.amplitude = fuzz_real(m, 0, 5e-4);
    d.frequency = fuzz_real(m, 0, 200);
    d.phase = fuzz_real(m, 0, 6);
    if (!fuzz_below(m, 3)) d.start = dem_world_time_get(m->world) + (double)fuzz_real(m, -1e-3, 1e-3);
    d.function = fuzz_motion;
    if (d.kind == DEM_MOTION_SERVO) {           /* small and large loads, constant or from the table, as force or stress */
        for (k = 0; k < 4; k++) rows[k].load = fuzz_real(m, -0.01, 1);
        d.load = fuzz_real(m, -0.01, 1);
        if (fuzz_below(m, 2)) d.table = 0, d.table_count = 0;
        if (fuzz_below(m, 2)) d.area = DEM_R(9e-4);
        if (fuzz_below(m, 2)) d.travel = fuzz_real(m, 0, 5e-3);
    }
    fuzz_say(m, "dem_wall_motion_set %d: kind %d, start %.9g", (int)wall.id, (int)d.kind, d.start);
    fuzz_result(m, dem_wall_motion_set(m->world, wall, &d));
}
static void fuzz_wall_remove(fuzz_machine *m) {
    const dem_wall wall = fuzz_wall(m);
    fuzz_say(m, "dem_wall_remove %d", (int)wall.id);
    fuzz_result(m, dem_wall_remove(m->world, wall));
}

/* ---- calls: feeds, outlets, fields ---- */
static dem_box fuzz_box(fuzz_machine *m) {
    dem_box b = dem_box_make((dem_real)fuzz_lo, (dem_real)fuzz_lo, (dem_real)fuzz_lo, (dem_real)fuzz_hi,
                             (dem_real)fuzz_hi, (dem_real)fuzz_hi);
    if (fuzz_below(m, 2)) b.lo.z = DEM_R(0.015);
    if (!fuzz_below(m, 3)) b.hi.x = DEM_R(0.018);
    return b;
}
static void fuzz_feed(fuzz_machine *m) {
    dem_sizes sizes = DEM_SIZES;
    dem_feed_desc d;
    int k;
    memset(&d, 0, sizeof d);
    d.material = fuzz_material(m);
    d.class_count = 1 + fuzz_below(m, 3);
    d.limited = fuzz_below(m, 2);
    d.by_mass = !fuzz_below(m, 4);
    for (k = 0; k < d.class_count; k++) {
        d.radius[k] = fuzz_real(m, 5e-4, 1.2e-3);
        d.amount[k] = d.by_mass ? 1e-4 : 1 + fuzz_below(m, 8);
    }
    d.rate = d.limited && fuzz_below(m, 2) ? 0 : d.by_mass ? 1 : (double)fuzz_real(m, 1e3, 2e4);
    if (fuzz_below(m, 2)) d.start = (double)fuzz_real(m, 0, 5e-4);
    if (!fuzz_below(m, 4)) d.end = d.start + 1e-3;
    d.box = fuzz_box(m);
    d.round = fuzz_below(m, 2);
    d.velocity = fuzz_vector(m, -0.5, 0.5);
    d.spread = fuzz_below(m, 2) ? DEM_R(0.3) : 0;
    d.seed = (uint64_t)fuzz_below(m, 1000);
    sizes.kind = DEM_SIZES_NORMAL;
    sizes.median = DEM_R(8e-4);
    sizes.deviation = DEM_R(1e-4);
    for (k = 0; k < d.class_count && !fuzz_below(m, 3); k++) {      /* a mixture */
        if (fuzz_below(m, 2)) d.materials[k] = fuzz_material(m);
        if (m->shapes && fuzz_below(m, 2)) d.shapes[k].id = 1 + fuzz_below(m, m->shapes);
        if (fuzz_below(m, 2)) d.sizes[k] = &sizes;
    }
    fuzz_say(m, "dem_feed_add: classes %d, limited %d, by_mass %d, rate %g, start %g, end %g, shape %d", d.class_count,
             d.limited, d.by_mass, d.rate, d.start, d.end, (int)d.shapes[0].id);
    if (fuzz_id(m, dem_feed_add(m->world, &d).id)) m->feeds++;
}
static void fuzz_outlet(fuzz_machine *m) {
    dem_outlet_desc d;
    memset(&d, 0, sizeof d);
    if (m->walls && !fuzz_below(m, 3)) d.frame = fuzz_wall(m);
    d.box = dem_box_make(-1, -1, -1, 1, 1, (dem_real)fuzz_lo + fuzz_real(m, -1e-3, 3e-3));
    if (d.frame.id) d.box.hi.z = fuzz_real(m, -1e-3, 3e-3);
    if (!fuzz_below(m, 3)) d.beyond = DEM_R(0.008);
    if (fuzz_below(m, 2)) d.wanted_max = DEM_R(8e-4);
    d.class_count = fuzz_below(m, 3);
    d.radius[0] = DEM_R(6e-4);
    d.radius[1] = DEM_R(9e-4);
    fuzz_say(m, "dem_outlet_add: frame %d, below z %g, beyond %g", (int)d.frame.id, (double)d.box.hi.z,
             (double)d.beyond);
    if (fuzz_id(m, dem_outlet_add(m->world, &d).id)) m->outlets++;
}
static void fuzz_field(fuzz_machine *m) {
    dem_field_desc d;
    int k;
    memset(&d, 0, sizeof d);
    d.box = fuzz_box(m);
    for (k = 0; k < 3; k++) d.cells[k] = 1 + fuzz_below(m, 5);
    if (fuzz_below(m, 2)) d.interval = 2e-5;
    if (!fuzz_below(m, 3)) d.start = 1e-4;
    fuzz_say(m, "dem_field_add: %d %d %d cells, start %g, interval %g", d.cells[0], d.cells[1], d.cells[2],
             d.start, d.interval);
    if (fuzz_id(m, dem_field_add(m->world, &d).id)) m->fields++;
}

/* ---- calls: bodies ---- */
static dem_vec3 fuzz_place(fuzz_machine *m) { return fuzz_vector(m, fuzz_lo + 1e-3, fuzz_hi - 1e-3); }
static void fuzz_sphere(fuzz_machine *m) {
    const dem_material stuff = fuzz_material(m);
    const dem_real r = fuzz_below(m, 8) ? fuzz_real(m, 5e-4, 1.2e-3) : fuzz_real(m, 1e-4, 3e-3);
    const dem_vec3 x = fuzz_place(m);
    dem_body b;
    fuzz_say(m, "dem_sphere_add %d radius %.9g", (int)stuff.id, (double)r);
    fuzz_say_vector(m, "at", x);
    b = dem_sphere_add(m->world, stuff, r, x);
    fuzz_note_int(m, (int)b.generation);
    fuzz_id(m, (int32_t)b.slot);
}
/* A lattice in which neighbours touch, or nearly. */
enum { FUZZ_LATTICE = 8*8*8 };
static void fuzz_spheres(fuzz_machine *m) {
    static dem_real x[3*FUZZ_LATTICE], v[3*FUZZ_LATTICE], r[FUZZ_LATTICE];
    const dem_material stuff = fuzz_material(m);
    const int nx = 1 + fuzz_below(m, 8), ny = 1 + fuzz_below(m, 8);
    const int planar = dem_world_desc_get(m->world).planar;
    const int nz = 1 + fuzz_below(m, planar ? 1 : 5), n = nx*ny*nz;
    const double radius = 1e-3, pitch = radius*(double)fuzz_real(m, 1.96, 2.1);
    const int moving = fuzz_below(m, 4), mixed = fuzz_below(m, 2);
    int i, k;
    for (i = 0; i < n; i++) {
        x[3*i] = (dem_real)(fuzz_lo + radius*0.99 + pitch*(i%nx));
        x[3*i + 1] = (dem_real)(fuzz_lo + radius*0.99 + pitch*(i/nx%ny));
        x[3*i + 2] = (dem_real)(fuzz_lo + radius*0.99 + pitch*(i/nx/ny));
        for (k = 0; k < 3; k++) v[3*i + k] = fuzz_real(m, -1, 1);
        r[i] = (dem_real)radius*(mixed ? fuzz_real(m, 0.9, 1.02) : DEM_R(1));
    }
    fuzz_say(m, "dem_spheres_add %d: %d x %d x %d, pitch %.9g, moving %d, mixed %d", (int)stuff.id, nx, ny, nz,
             pitch, moving > 0, mixed);
    fuzz_result(m, dem_spheres_add(m->world, stuff, n, x, moving ? v : 0, mixed ? r : 0, (dem_real)radius));
}
static void fuzz_count(fuzz_machine *m, int count) {      /* of those that found a place: less is no refusal */
    fuzz_note_int(m, count);
    fuzz_say(m, " -> %d", count);
}
static void fuzz_fill(fuzz_machine *m) {
    const dem_material stuff = fuzz_material(m);
    const dem_real r = fuzz_real(m, 6e-4, 1.2e-3);
    const dem_box box = fuzz_box(m);
    const int count = 1 + fuzz_below(m, 120);
    const uint64_t seed = (uint64_t)fuzz_below(m, 100);
    fuzz_say(m, "dem_spheres_fill %d radius %.9g count %d", (int)stuff.id, (double)r, count);
    fuzz_count(m, dem_spheres_fill(m->world, stuff, r, dem_region_make(box), count, seed));
}
static void fuzz_pack(fuzz_machine *m) {
    const dem_material stuff = fuzz_material(m);
    const dem_real r = fuzz_real(m, 8e-4, 1.2e-3), padding = fuzz_below(m, 2) ? 0 : DEM_R(5e-5);
    const dem_box box = fuzz_box(m);
    const int inside = fuzz_below(m, 2), count = 1 + fuzz_below(m, 150);
    fuzz_say(m, "dem_spheres_pack %d radius %.9g padding %g inside %d count %d", (int)stuff.id, (double)r,
             (double)padding, inside, count);
    fuzz_count(m, dem_spheres_pack(m->world, stuff, r, padding,
                                   dem_region_inside_make(box, inside ? fuzz_inside : 0, 0), count));
}
static void fuzz_body_add(fuzz_machine *m) {
    const dem_material stuff = fuzz_material(m);
    const dem_shape shape = fuzz_shape(m);
    const dem_vec3 x = fuzz_place(m);
    const dem_quat q = fuzz_turn(m);
    dem_body b;
    fuzz_say(m, "dem_body_add %d shape %d", (int)stuff.id, (int)shape.id);
    fuzz_say_vector(m, "at", x);
    b = dem_body_add(m->world, stuff, shape, x, q);
    fuzz_note_int(m, (int)b.generation);
    fuzz_id(m, (int32_t)b.slot);
}
static void fuzz_bodies_add(fuzz_machine *m) {
    static dem_real x[3*64], q[4*64], v[3*64], s[3*64], scale[64];
    const dem_material stuff = fuzz_material(m);
    const dem_shape shape = fuzz_shape(m);
    const int n = 1 + fuzz_below(m, 64), with = fuzz_below(m, 16);
    const double pitch = 2.6e-3;
    int i, k;
    for (i = 0; i < n; i++) {
        const dem_quat turn = fuzz_turn(m);
        x[3*i] = (dem_real)(fuzz_lo + 1e-3 + pitch*(i%6));
        x[3*i + 1] = (dem_real)(fuzz_lo + 1e-3 + pitch*(i/6%6));
        x[3*i + 2] = (dem_real)(fuzz_lo + 1e-3 + pitch*(i/36));
        q[4*i] = turn.w; q[4*i + 1] = turn.x; q[4*i + 2] = turn.y; q[4*i + 3] = turn.z;
        for (k = 0; k < 3; k++) { v[3*i + k] = fuzz_real(m, -1, 1); s[3*i + k] = fuzz_real(m, -100, 100); }
        scale[i] = fuzz_real(m, 0.7, 1.1);
    }
    fuzz_say(m, "dem_bodies_add %d shape %d count %d with %d", (int)stuff.id, (int)shape.id, n, with);
    fuzz_result(m, dem_bodies_add(m->world, stuff, shape, n, x, with & 1 ? q : 0, with & 2 ? v : 0,
                                  with & 4 ? s : 0, with & 8 ? scale : 0));
}
static void fuzz_bodies_fill(fuzz_machine *m) {
    const dem_material stuff = fuzz_material(m);
    const dem_shape shape = fuzz_shape(m);
    const dem_box box = fuzz_box(m);
    const int count = 1 + fuzz_below(m, 60);
    const uint64_t seed = (uint64_t)fuzz_below(m, 100);
    fuzz_say(m, "dem_bodies_fill %d shape %d count %d", (int)stuff.id, (int)shape.id, count);
    fuzz_count(m, dem_bodies_fill(m->world, stuff, shape, dem_region_make(box), count, seed));
}
static void fuzz_body_set(fuzz_machine *m) {
    const dem_body b = fuzz_body(m);
    const int what = fuzz_below(m, 6);
    dem_body_state s;
    memset(&s, 0, sizeof s);
    if (dem_body_get(m->world, b, &s) != DEM_OK) { fuzz_result(m, dem_body_get(m->world, b, &s)); return; }
    if (what == 0) s.position = fuzz_place(m);
    if (what == 1) s.velocity = fuzz_vector(m, -2, 2);
    if (what == 2) s.spin = fuzz_vector(m, -300, 300);
    if (what == 3) s.fixed = !s.fixed;
    if (what == 4) s.orientation = fuzz_turn(m);
    if (what == 5) s.position.x += fuzz_real(m, -1e-5, 1e-5);
    fuzz_say(m, "dem_body_set slot %u: %s", (unsigned)b.slot, what == 0 ? "position" : what == 1 ? "velocity" :
             what == 2 ? "spin" : what == 3 ? "fixed" : what == 4 ? "orientation" : "position a little");
    fuzz_result(m, dem_body_set(m->world, b, &s));
}
static void fuzz_body_remove(fuzz_machine *m) {
    const dem_body b = fuzz_body(m);
    fuzz_say(m, "dem_body_remove slot %u", (unsigned)b.slot);
    if (fuzz_result(m, dem_body_remove(m->world, b))) {
        m->bodies_gone = 1;
        if (dem_body_remove(m->world, b) == DEM_OK) fuzz_fail("%c: a body was removed twice", m->name);
    }
}
static void fuzz_bodies_remove(fuzz_machine *m) {
    const int every = 1 + fuzz_below(m, 4);
    int i, gone = 0;
    fuzz_say(m, "dem_body_remove: one of %d, from the last", every);
    for (i = dem_bodies_get(m->world).count - 1; i >= 0; i--) {
        if (fuzz_below(m, every) || i >= dem_bodies_get(m->world).count) continue;
        if (!fuzz_result(m, dem_body_remove(m->world, dem_body_id_get(m->world, i)))) break;
        gone++;
    }
    if (gone) m->refusable = 0;
    m->bodies_gone |= gone > 0;
}

/* ---- calls: joints ---- */
static dem_joint fuzz_joint(fuzz_machine *m) {
    dem_joint id;
    id.id = 1 + fuzz_below(m, m->joints + !fuzz_below(m, 9));
    return id;
}
static void fuzz_joint_add(fuzz_machine *m) {
    dem_joint_desc d = DEM_JOINT_DESC;
    const dem_bodies all = dem_bodies_get(m->world);
    d.kind = fuzz_below(m, 2) ? DEM_JOINT_REVOLUTE : DEM_JOINT_POINT;
    d.a = fuzz_body(m);
    if (fuzz_below(m, 2)) d.b = fuzz_body(m);
    else if (m->walls && fuzz_below(m, 2)) d.wall = fuzz_wall(m);
    d.collide = !fuzz_below(m, 3);
    d.axis = fuzz_vector(m, -1, 1);
    d.point = fuzz_vector(m, fuzz_lo, fuzz_hi);
    if (all.count) {
        const int i = fuzz_below(m, all.count);
        d.point = dem_vec3_make(all.positions[4*i], all.positions[4*i + 1], all.positions[4*i + 2]);
    }
    if (d.kind == DEM_JOINT_REVOLUTE && fuzz_below(m, 2)) {
        d.motor = fuzz_below(m, 2) ? DEM_MOTOR_SPEED : DEM_MOTOR_TORQUE;
        d.speed = d.motor == DEM_MOTOR_SPEED ? fuzz_real(m, -50, 50) : 0;
        d.torque = fuzz_real(m, 0, 1e-4);
    }
    fuzz_say(m, "dem_joint_add: kind %d, bodies %u %u, wall %d, collide %d, motor %d %g %g", (int)d.kind, d.a.slot,
             d.b.slot, (int)d.wall.id, d.collide, (int)d.motor, (double)d.speed, (double)d.torque);
    fuzz_say_vector(m, "point", d.point);
    if (fuzz_id(m, dem_joint_add(m->world, &d).id)) m->joints++;
}
static void fuzz_joint_change(fuzz_machine *m) {
    const dem_joint id = fuzz_joint(m);
    if (fuzz_below(m, 3)) {
        fuzz_say(m, "dem_joint_motor_set %d", (int)id.id);
        fuzz_result(m, dem_joint_motor_set(m->world, id, (dem_motor)fuzz_below(m, 3), fuzz_real(m, -50, 50),
                                       fuzz_real(m, 0, 1e-4)));
    } else {
        fuzz_say(m, "dem_joint_remove %d", (int)id.id);
        fuzz_result(m, dem_joint_remove(m->world, id));
    }
}

/* ---- calls: running ---- */
static void fuzz_ran(fuzz_machine *m, dem_result r, uint64_t steps) {
    fuzz_result(m, r);
    m->unstable |= r == DEM_ERROR_UNSTABLE;
    if (r == DEM_ERROR_UNSTABLE || r == DEM_ERROR_MEMORY) m->refusable = 0;   /* stops in the middle */
    if (r == DEM_ERROR_TIME_STEP) m->refusable = 0;         /* also found out on the way */
    if (r == DEM_ERROR_ARGUMENT && m->feeds && fuzz_avoids.step_refused_after_feed) m->refusable = 0;
    /* a wall that moved grew longer than the period in the middle of a step */
    if (r == DEM_ERROR_ARGUMENT && strstr(dem_world_error_get(m->world), "longer than the period"))
        m->refusable = 0;
    if (dem_world_steps_get(m->world) == steps) return;
    if (r == DEM_OK) m->bodies_gone = 0;
    if (r == DEM_OK && dem_counters_get(m->world).rebuilds != m->rebuilds) m->pairs_new = 0;
}
static void fuzz_step(fuzz_machine *m) {
    const int n = fuzz_below(m, 3) ? 1 + fuzz_below(m, 40) : fuzz_below(m, 3);
    fuzz_say(m, "dem_world_step %d", n);
    {
        const uint64_t steps = dem_world_steps_get(m->world);
        fuzz_ran(m, dem_world_step(m->world, n), steps);
    }
}
static void fuzz_run(fuzz_machine *m) {
    const double used = (double)dem_counters_get(m->world).dt;
    dem_advice advice;
    const dem_result known = dem_step_advice_get(m->world, &advice);    /* grains may be new since */
    const double dt = known == DEM_OK && (double)advice.dt < used ? (double)advice.dt : used;
    const double seconds = dt*(double)fuzz_real(m, 0.6, 30);
    fuzz_say(m, "dem_world_run %.17g", seconds);
    if (!(dt > 0)) { fuzz_say(m, " (no time step yet: left out)"); return; }
    {
        const uint64_t steps = dem_world_steps_get(m->world);
        fuzz_ran(m, dem_world_run(m->world, seconds, fuzz_progress, 0), steps);
        fuzz_say(m, " (%d steps)", (int)(dem_world_steps_get(m->world) - steps));
    }
}
static void fuzz_search(fuzz_machine *m) {
    fuzz_say(m, "dem_candidates_rebuild");
    if (fuzz_result(m, dem_candidates_rebuild(m->world))) m->bodies_gone = 0;
}

/* Makes a list, too, where there is none. */
static void fuzz_check(fuzz_machine *m) {
    const uint64_t rebuilds = dem_counters_get(m->world).rebuilds;
    dem_finding f[32];
    int n, i;
    fuzz_say(m, "dem_world_check");
    n = dem_world_check(m->world, f, 32);
    for (i = 0; i < n && i < 32; i++)           /* threads are not the same in both */
        if (strncmp(f[i].text, "threads is", 10)) fuzz_note(m, f[i].text, strlen(f[i].text));
    if (dem_counters_get(m->world).rebuilds != rebuilds) m->bodies_gone = m->pairs_new = 0;
}

/* ---- looking: everything that can be asked; changes nothing ---- */
static void fuzz_look_contacts(fuzz_machine *m) {
    static dem_contact_info c[FUZZ_CONTACTS];
    static uint32_t pairs[2*FUZZ_CONTACTS];
    const int n = dem_contacts_get(m->world, c, FUZZ_CONTACTS), p = dem_candidates_get(m->world, pairs, FUZZ_CONTACTS);
    int i;
    fuzz_note_int(m, n);
    for (i = 0; i < n && i < FUZZ_CONTACTS; i++) {
        fuzz_note(m, &c[i].a, sizeof c[i].a);
        fuzz_note(m, &c[i].b, sizeof c[i].b);
        fuzz_note_int(m, c[i].wall);
        fuzz_note_vector(m, c[i].point);
        fuzz_note_vector(m, c[i].normal);
        fuzz_note_real(m, (double)c[i].overlap);
        fuzz_note_vector(m, c[i].force);
    }
    fuzz_note_int(m, p);
    if (p > 0) fuzz_note(m, pairs, 2*sizeof(uint32_t)*(size_t)(p < FUZZ_CONTACTS ? p : FUZZ_CONTACTS));
}
static void fuzz_look_bodies(fuzz_machine *m) {
    const dem_bodies b = dem_bodies_get(m->world);
    const size_t n = (size_t)b.count, r = sizeof(dem_real);
    const dem_body_counts balance = dem_body_counts_get(m->world);
    int i, k;
    fuzz_note(m, &balance, sizeof balance);
    fuzz_note_int(m, b.count);
    if (balance.present != n || balance.inserted != balance.present + balance.removed + balance.left)
        fuzz_fail("%c: inserted %d, present %d (counted %d), removed %d, left %d", m->name, (int)balance.inserted,
                  (int)balance.present, b.count, (int)balance.removed, (int)balance.left);
    if (!n) return;
    for (i = 0; i < b.count; i++)
        for (k = 0; k < 3; k++) {
            fuzz_note(m, b.positions + 4*i + k, r);
            fuzz_note(m, b.velocities + 4*i + k, r);
            fuzz_note(m, b.spins + 4*i + k, r);
            fuzz_note(m, b.forces + 4*i + k, r);
            fuzz_note(m, b.torques + 4*i + k, r);
        }
    fuzz_note(m, b.masses, n*r);
    fuzz_note(m, b.slots, n*sizeof *b.slots);
    fuzz_note(m, b.materials, n*sizeof *b.materials);
    if (b.orientations) fuzz_note(m, b.orientations, 4*n*r);
    if (b.shapes) fuzz_note(m, b.shapes, n*sizeof *b.shapes);
}
static void fuzz_look_counts(fuzz_machine *m) {
    const dem_counters c = dem_counters_get(m->world);
    const dem_ledger l = dem_ledger_get(m->world);
    const dem_totals t = dem_totals_get(m->world);
    dem_advice a;
    int i;
    memset(&a, 0, sizeof a);
    fuzz_note(m, &c.steps, sizeof c.steps);
    fuzz_note(m, &c.rebuilds, sizeof c.rebuilds);
    fuzz_note_int(m, c.candidates);
    if (!fuzz_avoids.stale_domains) { fuzz_note_int(m, c.contacts); fuzz_note_int(m, c.wall_contacts); }
    fuzz_note_real(m, (double)c.overlap_max); fuzz_note_real(m, (double)c.speed_max);
    fuzz_note_real(m, (double)c.skin); fuzz_note_real(m, (double)c.dt);
    fuzz_note_int(m, (int)c.search); fuzz_note_int(m, c.domains);
    fuzz_note(m, &l, sizeof l);
    fuzz_note(m, &t, sizeof t);
    fuzz_note_real(m, dem_world_time_get(m->world));
    fuzz_note_int(m, (int)dem_step_advice_get(m->world, &a));
    fuzz_note_real(m, (double)a.dt); fuzz_note_real(m, (double)a.dt_max); fuzz_note_real(m, (double)a.speed);
    fuzz_note_real(m, (double)a.contact_time); fuzz_note_real(m, (double)a.rayleigh);
    fuzz_note(m, a.binds, strlen(a.binds));
    for (i = 1; i <= m->feeds; i++) {
        dem_feed id;
        dem_feed_state s;
        id.id = i;
        if (dem_feed_get(m->world, id, &s) != DEM_OK) fuzz_fail("%c: feed %d is gone", m->name, i);
        else fuzz_note(m, &s, sizeof s - sizeof(int));
    }
    for (i = 1; i <= m->outlets; i++) {
        dem_outlet id;
        dem_outlet_state s;
        id.id = i;
        if (dem_outlet_get(m->world, id, &s) != DEM_OK) fuzz_fail("%c: outlet %d is gone", m->name, i);
        else fuzz_note(m, &s, sizeof s);
    }
}
static void fuzz_look_walls(fuzz_machine *m) {
    int i, k;
    for (i = 1; i <= m->joints; i++) {
        dem_joint id;
        dem_joint_state s;
        id.id = i;
        memset(&s, 0, sizeof s);
        fuzz_note_int(m, (int)dem_joint_get(m->world, id, &s));
        fuzz_note(m, &s, sizeof s);
    }
    for (i = 0; i < m->walls; i++) {
        dem_wall id;
        dem_wall_loads c;
        dem_pose p;
        id.id = m->wall[i];
        memset(&c, 0, sizeof c);
        memset(&p, 0, sizeof p);
        fuzz_note_int(m, (int)dem_wall_loads_get(m->world, id, &c));
        fuzz_note_vector(m, c.force); fuzz_note_vector(m, c.torque);
        fuzz_note_real(m, (double)c.torque_axial); fuzz_note_real(m, (double)c.power);
        fuzz_note_int(m, c.contacts);
        for (k = 0; k < 3; k++) fuzz_note_real(m, c.impulse[k]);
        fuzz_note_real(m, c.torque_impulse); fuzz_note_real(m, c.work); fuzz_note_real(m, c.time);
        fuzz_note_int(m, (int)dem_wall_pose_get(m->world, id, &p));
        fuzz_note(m, &p, sizeof p);
        fuzz_note_int(m, dem_sieve_blinded_get(m->world, id, 0));
    }
    for (i = 1; i <= m->fields; i++) {
        dem_field id;
        dem_field_data d;
        size_t cells;
        id.id = i;
        if (dem_field_get(m->world, id, &d) != DEM_OK) { fuzz_fail("%c: field %d is gone", m->name, i); continue; }
        cells = (size_t)d.cells[0]*(size_t)d.cells[1]*(size_t)d.cells[2];
        fuzz_note(m, &d.samples, sizeof d.samples);
        fuzz_note(m, d.solid, cells*sizeof(double));
        fuzz_note(m, d.mass, cells*sizeof(double));
        fuzz_note(m, d.momentum, 3*cells*sizeof(double));
    }
}
static uint64_t fuzz_part(fuzz_machine *m, void (*look)(fuzz_machine *)) {
    const uint64_t answer = m->answer;
    uint64_t part;
    m->answer = UINT64_C(14695981039346656037);
    look(m);
    part = m->answer;
    m->answer = answer;
    return part;
}
enum { FUZZ_PARTS = 5 };
static const char *const fuzz_part_names[FUZZ_PARTS] = {"hash", "bodies in order", "contacts or candidates",
    "counters, ledger, totals, advice, feeds or outlets", "walls, fields or joints"};
static void fuzz_look(fuzz_machine *m, uint64_t parts[FUZZ_PARTS]) {
    parts[0] = dem_world_hash_get(m->world);
    parts[1] = fuzz_part(m, fuzz_look_bodies);
    parts[2] = fuzz_part(m, fuzz_look_contacts);
    parts[3] = fuzz_part(m, fuzz_look_counts);
    parts[4] = fuzz_part(m, fuzz_look_walls);
    if (parts[0] != dem_world_hash_get(m->world)) fuzz_fail("%c: looking changed the hash", m->name);
}
/* For the reader of a failing program: the numbers that most often differ. */
static void fuzz_show(const fuzz_machine *m) {
    const dem_counters c = dem_counters_get(m->world);
    const dem_ledger l = dem_ledger_get(m->world);
    dem_advice a;
    memset(&a, 0, sizeof a);
    dem_step_advice_get(m->world, &a);
    printf("\n    %c: steps %d, rebuilds %d, candidates %d, contacts %d, wall contacts %d, overlap %.17g, speed %.17g, "
           "skin %.17g, dt %.17g, search %d, domains %d; stored %.17g %.17g %.17g, residual %.17g; advice %.17g (%s)",
           m->name, (int)c.steps, (int)c.rebuilds, c.candidates, c.contacts, c.wall_contacts, (double)c.overlap_max,
           (double)c.speed_max, (double)c.skin, (double)c.dt, (int)c.search, c.domains, l.kinetic, l.rotational,
           l.elastic, l.residual, (double)a.dt, a.binds);
}
static int fuzz_same(fuzz_machine *a, fuzz_machine *b, const char *when) {
    uint64_t one[FUZZ_PARTS], two[FUZZ_PARTS];
    int k, same = 1;
    fuzz_look(a, one);
    fuzz_look(b, two);
    for (k = 0; k < FUZZ_PARTS; k++)
        if (one[k] != two[k]) {
            fuzz_fail("%c and %c differ %s: %s", a->name, b->name, when, fuzz_part_names[k]);
            same = 0;
        }
    if (!same && (a->printing || b->printing)) { fuzz_show(a); fuzz_show(b); printf("\n"); }
    return same;
}
static void fuzz_look_all(fuzz_machine *m) {
    uint64_t parts[FUZZ_PARTS];
    fuzz_say(m, "look at everything");
    fuzz_look(m, parts);
    fuzz_note(m, parts, sizeof parts);
}
static void fuzz_report(fuzz_machine *m) {
    const dem_material a = fuzz_material(m), b = fuzz_material(m);
    dem_coefficients c;
    FILE *f = tmpfile();
    fuzz_say(m, "dem_world_report, dem_pairs_print, dem_coefficients_get");
    memset(&c, 0, sizeof c);
    if (f) {
        dem_world_report(m->world, f);
        dem_pairs_print(m->world, f);
        fclose(f);
    }
    if (fuzz_result(m, dem_coefficients_get(m->world, a, b, DEM_R(1e-3), DEM_R(1e-3), &c))) fuzz_note(m, &c, sizeof c);
}
static void fuzz_resets(fuzz_machine *m) {
    dem_field field;
    dem_outlet outlet;
    const int what = fuzz_below(m, 4);
    field.id = m->fields ? 1 + fuzz_below(m, m->fields) : 1;
    outlet.id = m->outlets ? 1 + fuzz_below(m, m->outlets) : 1;
    fuzz_say(m, what == 0 ? "dem_overlap_max_reset" : what == 1 ? "dem_wall_loads_reset" : what == 2 ?
             "dem_field_reset" : "dem_outlet_reset");
    if (what == 0) dem_overlap_max_reset(m->world);
    if (what == 1) fuzz_result(m, dem_wall_loads_reset(m->world, fuzz_wall(m)));
    if (what == 2) fuzz_result(m, dem_field_reset(m->world, field));
    if (what == 3) fuzz_result(m, dem_outlet_reset(m->world, outlet));
}
/* What a companion answers stands in its own sentence, not in the world's. */
static int fuzz_moldyn_result(fuzz_machine *m, const moldyn *d, dem_result r) {
    fuzz_note_int(m, (int)r);
    if (r != DEM_OK) fuzz_refused(m, d->error);
    return r == DEM_OK;
}
static void fuzz_files(fuzz_machine *m) {
    static const char *const names[] = {".vtp", ".vtk", ".xyz", ".walls.vtp", ".csv", ".xb", ".str",
                                        ".surfaces.vtp"};
    const int what = fuzz_below(m, 8);
    dem_result r = DEM_OK;
    const dem_wall wall = fuzz_wall(m);
    moldyn d = MOLDYN;
    char path[200];
    fuzz_path(names[what], m->name == 'B' ? 'B' : 'A', path);
    fuzz_say(m, "write %s", names[what]);
    remove(path);
    if (what == 0) r = dem_vtp_write(m->world, path);
    if (what == 1) r = dem_vtk_write(m->world, path);
    if (what == 2) r = dem_xyz_write(m->world, path);
    if (what == 3) r = dem_walls_vtp_write(m->world, path, 0, DEM_R(0.03));
    if (what == 4) r = dem_wall_loads_csv_write(m->world, wall, path);
    if (what == 5) r = moldyn_xb_append(&d, m->world, path, dem_box_make(0, 0, 0, 1, 1, 1));
    if (what == 6) r = moldyn_str_append(&d, m->world, path, 1e-3, 10, &wall, 1);
    if (what == 7) r = dem_surfaces_vtp_write(m->world, path);
    if (what != 5 && what != 6 ? fuzz_result(m, r) : fuzz_moldyn_result(m, &d, r)) fuzz_note_file(m, path);
    remove(path);
}
/* A replay of some steps, with a number of its own or one of the world's. */
static void fuzz_replay(fuzz_machine *m) {
    dem_replay_desc d = DEM_REPLAY_DESC;
    dem_replay *film;
    dem_result r = DEM_OK;
    char path[200];
    int k;
    fuzz_path(".html", m->name, path);
    if (fuzz_below(m, 2)) d.number_fn = fuzz_number;
    if (fuzz_below(m, 2)) d.interval = 2e-5;
    fuzz_say(m, "replay: number %d, interval %g", d.number_fn != 0, d.interval);
    film = dem_replay_open(m->world, path, &d);
    if (!film) { fuzz_fail("%c: no replay: %s", m->name, dem_world_error_get(m->world)); return; }
    for (k = 0; k < 3 && r == DEM_OK; k++) {
        dem_replay_value_set(film, "k", k);
        dem_replay_frame_write(film);
        r = dem_world_step(m->world, 4);
    }
    m->unstable |= r == DEM_ERROR_UNSTABLE;
    if (r == DEM_OK) m->bodies_gone = m->pairs_new = 0;
    if (dem_replay_close(film) != DEM_OK) fuzz_fail("%c: the replay does not close: %s", m->name, dem_world_error_get(m->world));
    fuzz_note_int(m, (int)r);
    remove(path);
}
static void fuzz_output(fuzz_machine *m) {
    dem_output_desc d = DEM_OUTPUT_DESC;
    dem_output output;
    char path[200];
    const int kind = fuzz_below(m, 4);
    d.kind = kind == 0 ? DEM_OUTPUT_CALL : kind == 1 ? DEM_OUTPUT_VTP : DEM_OUTPUT_CSV;
    fuzz_path(kind == 1 ? ".out.vtp" : kind == 2 ? ".out.csv" : ".own.csv", m->name, path);
    d.path = path;
    d.interval = (double)fuzz_real(m, 2e-5, 2e-4);
    d.start = (double)fuzz_real(m, 0, 1e-4);
    if (kind == 0) d.function = fuzz_output_call;
    if (kind == 3) { d.columns = "kinetic"; d.values = fuzz_values; }
    fuzz_say(m, "dem_output_add: kind %d, interval %g", (int)d.kind, d.interval);
    output = dem_output_add(m->world, &d);
    fuzz_id(m, output.id);
    if (!fuzz_below(m, 3)) fuzz_result(m, dem_output_remove(m->world, output));
}
static void fuzz_reals_set(fuzz_machine *m) {
    dem_real reals[DEM_BODY_REALS];
    int k;
    for (k = 0; k < DEM_BODY_REALS; k++) reals[k] = fuzz_real(m, -1, 1);
    fuzz_say(m, "dem_body_reals_set, dem_wall_reals_set");
    if (fuzz_result(m, dem_body_reals_set(m->world, fuzz_body(m), reals)) &&
        fuzz_result(m, dem_body_reals_get(m->world, fuzz_body(m), reals))) fuzz_note_real(m, (double)reals[0]);
}
static void fuzz_moldyn(fuzz_machine *m) {
    moldyn d = MOLDYN;
    char cin[200], pin[200];
    fuzz_path(".cin", m->name == 'B' ? 'B' : 'A', cin);
    fuzz_path(".pin", m->name == 'B' ? 'B' : 'A', pin);
    fuzz_say(m, "moldyn_take, moldyn_write");
    d.density = d.stiffness = d.dt = 1;
    if (fuzz_moldyn_result(m, &d, moldyn_take(&d, m->world)) &&
        fuzz_moldyn_result(m, &d, moldyn_write(&d, 0, pin, 0))) fuzz_note_file(m, pin);
    moldyn_free(&d);
    remove(cin);
    remove(pin);
}

/* ---- calls: slabs ---- */
static void fuzz_slabs_error(fuzz_machine *m, dem_result r) {
    fuzz_note_int(m, (int)r);
    if (r != DEM_OK) fuzz_refused(m, dem_slabs_error_get(m->slabs));
}
static void fuzz_slabs_create(fuzz_machine *m) {
    dem_slabs_desc d = DEM_SLABS_DESC;
    d.axis = fuzz_below(m, 3);
    d.count = 1 + fuzz_below(m, 4);
    if (!fuzz_below(m, 3)) { d.balance = DEM_R(1.01); d.balance_interval = 1; }
    fuzz_say(m, "dem_slabs_create: axis %d, count %d", d.axis, d.count);
    if (m->slabs) dem_slabs_destroy(m->slabs);
    m->slabs = dem_slabs_create(m->world, &d);
    m->dealt = dem_body_counts_get(m->world);
    fuzz_id(m, m->slabs != 0);
}
static void fuzz_slabs_step(fuzz_machine *m) {
    const int n = fuzz_below(m, 30);
    dem_slabs_counters c;
    fuzz_say(m, "dem_slabs_step %d", n);
    if (!m->slabs) { fuzz_say(m, " (no slabs: left out)"); return; }
    fuzz_slabs_error(m, dem_slabs_step(m->slabs, n));
    m->refusable = 1;
    c = dem_slabs_counters_get(m->slabs);
    fuzz_note(m, &c.steps, sizeof c.steps);
    fuzz_note(m, &c.rebuilds, sizeof c.rebuilds);
    fuzz_note_real(m, c.time);
    if (!fuzz_below(m, 4)) dem_slabs_loads_reset(m->slabs);
}
static void fuzz_slabs_collect(fuzz_machine *m) {
    fuzz_say(m, "dem_slabs_collect");
    if (!m->slabs) { fuzz_say(m, " (no slabs: left out)"); return; }
    {
        const dem_body_counts now = dem_body_counts_get(m->world);
        if (fuzz_avoids.slabs_collect_changed && memcmp(&now, &m->dealt, sizeof now)) {
            fuzz_say(m, " (avoided)");
            return;
        }
    }
    fuzz_slabs_error(m, dem_slabs_collect(m->slabs, m->world));
    m->dealt = dem_body_counts_get(m->world);
    if (!m->failed) m->bodies_gone = 1;         /* the world has no list now */
}

/* ---- calls: checkpoints kept for later ---- */
static int fuzz_checkpoint_avoided(const fuzz_machine *m) {
    return (fuzz_avoids.checkpoint_after_pairs && m->pairs_new) ||
           (fuzz_avoids.checkpoint_after_remove && m->bodies_gone) ||
           (fuzz_avoids.stale_domains && m->domains_most > dem_counters_get(m->world).domains);
}
static void fuzz_save(fuzz_machine *m) {
    char path[200];
    fuzz_say(m, "dem_checkpoint_write, kept");
    if (fuzz_checkpoint_avoided(m)) { fuzz_say(m, " (avoided)"); return; }
    fuzz_path(".kept", m->name == 'B' ? 'B' : 'A', path);
    if (!fuzz_result(m, dem_checkpoint_write(m->world, path))) return;
    m->saved = 1;
    m->saved_scene = m->scene;
    m->saved_hash = dem_world_hash_get(m->world);
}
static void fuzz_restore(fuzz_machine *m) {
    char path[200];
    fuzz_say(m, "dem_checkpoint_read of the one kept");
    if (!m->saved) { fuzz_say(m, " (none: left out)"); return; }
    if (fuzz_avoids.checkpoint_oriented_reader && m->shapes) { fuzz_say(m, " (avoided)"); return; }
    fuzz_path(".kept", m->name == 'B' ? 'B' : 'A', path);
    if (fuzz_result(m, dem_checkpoint_read(m->world, path))) {
        if (dem_world_hash_get(m->world) != m->saved_hash)
            fuzz_fail("%c: a kept checkpoint gives another hash", m->name);
        m->bodies_gone = m->pairs_new = 0;
    } else if (m->scene == m->saved_scene && !m->memory->refused)
        fuzz_fail("%c: a kept checkpoint of the same scene is refused: %s", m->name, dem_world_error_get(m->world));
}
/* A byte of a good file is changed, or its end is missing. */
static void fuzz_damaged(fuzz_machine *m) {
    char path[200], bad[200];
    static unsigned char bytes[1 << 20];
    FILE *f;
    size_t n, k;
    fuzz_say(m, "dem_checkpoint_read of a damaged file");
    fuzz_path(".good", m->name == 'B' ? 'B' : 'A', path);
    fuzz_path(".bad", m->name == 'B' ? 'B' : 'A', bad);
    if (fuzz_checkpoint_avoided(m) || dem_checkpoint_write(m->world, path) != DEM_OK) return;
    f = fopen(path, "rb");
    n = f ? fread(bytes, 1, sizeof bytes, f) : 0;
    if (f) fclose(f);
    k = (size_t)fuzz_below(m, (int)(n < 200 || fuzz_below(m, 2) ? n : 200));
    if (fuzz_below(m, 2)) n = k;
    else bytes[k] = (unsigned char)(bytes[k] ^ (1 << fuzz_below(m, 8)));
    f = fopen(bad, "wb");
    if (f) { fwrite(bytes, 1, n, f); fclose(f); }
    m->must_fail = 1;
    {
        const dem_result r = dem_checkpoint_read(m->world, bad);   /* the sentence names the file */
        fuzz_note_int(m, (int)r);
        m->failed = m->refusable = r != DEM_OK;
        if (r != DEM_OK && !*dem_world_error_get(m->world)) fuzz_fail("%c: refused without a sentence", m->name);
    }
    remove(path);
    remove(bad);
}

/* ---- calls: bad ones ---- */
static void fuzz_refused_count(fuzz_machine *m, int count) {
    fuzz_note_int(m, count);
    if (count <= 0) fuzz_refused(m, dem_world_error_get(m->world));
}
static void fuzz_bad_grain(fuzz_machine *m) {
    static const dem_real spot[3] = {0, 0, 0};
    const dem_material stuff = fuzz_material(m), none = {77};
    const dem_vec3 at0 = dem_vec3_make(0, 0, 0), nowhere = dem_vec3_make((dem_real)NAN, 0, 0);
    const dem_box box = fuzz_box(m), turned = dem_box_make(1, 1, 1, 0, 0, 0);
    const dem_real bad = fuzz_bad(m);
    const int what = fuzz_below(m, 16);
    const dem_quat zero = dem_quat_make(0, 0, 0, 0);
    dem_cluster_desc cluster = DEM_CLUSTER_DESC;
    dem_shape shape;
    dem_body body;
    dem_body_state state;
    fuzz_say(m, "bad grain %d (%g)", what, (double)bad);
    shape.id = 77;
    body.slot = 5000;
    body.generation = 7;
    cluster.count = 1;
    cluster.positions = spot;
    cluster.radius = bad;
    memset(&state, 0, sizeof state);
    state.orientation.w = 1;
    switch (what) {
    case 0: fuzz_id(m, (int32_t)dem_sphere_add(m->world, none, DEM_R(1e-3), at0).slot); break;
    case 1: fuzz_id(m, (int32_t)dem_sphere_add(m->world, stuff, bad, at0).slot); break;
    case 2: fuzz_id(m, (int32_t)dem_sphere_add(m->world, stuff, DEM_R(1e-3), nowhere).slot); break;
    case 3: fuzz_result(m, dem_spheres_add(m->world, stuff, 1, spot, 0, 0, bad)); break;
    case 4: fuzz_result(m, dem_body_remove(m->world, body)); break;
    case 5: fuzz_result(m, dem_body_get(m->world, body, &state)); break;
    case 6: fuzz_result(m, dem_body_set(m->world, body, &state)); break;
    case 7: fuzz_refused_count(m, dem_spheres_fill(m->world, stuff, bad, dem_region_make(box), 10, 1)); break;
    case 8: fuzz_refused_count(m, dem_spheres_fill(m->world, stuff, DEM_R(1e-3), dem_region_make(turned), 10, 1)); break;
    case 9: fuzz_refused_count(m, dem_spheres_pack(m->world, stuff, bad, 0, dem_region_make(box), 10)); break;
    case 10: fuzz_refused_count(m, dem_spheres_pack(m->world, stuff, DEM_R(1e-3), -1, dem_region_make(box), 10)); break;
    case 11: fuzz_id(m, dem_shape_ellipsoid_add(m->world, dem_vec3_make(DEM_R(1e-3), DEM_R(1e-3), bad)).id); break;
    case 12: fuzz_id(m, dem_shape_cluster_add(m->world, &cluster).id); break;
    case 13: fuzz_id(m, (int32_t)dem_body_add(m->world, stuff, shape, at0, dem_quat_make(1, 0, 0, 0)).slot); break;
    case 14: shape = fuzz_shape(m); fuzz_id(m, (int32_t)dem_body_add(m->world, stuff, shape, at0, zero).slot); break;
    default:
        body = fuzz_body(m);
        if (dem_body_get(m->world, body, &state) == DEM_OK) state.position.y = (dem_real)INFINITY;
        fuzz_result(m, dem_body_set(m->world, body, &state));
    }
}
static void fuzz_bad_wall(fuzz_machine *m) {
    const int unknown[1] = {99};              /* an enum's value that C++ does not let a cast make */
    dem_real v[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    int32_t t[3] = {0, 1, 3};
    const dem_material stuff = fuzz_material(m), none = {-1};
    const dem_vec3 zero = dem_vec3_make(0, 0, 0), up = dem_vec3_make(0, 0, 1);
    const dem_real bad = fuzz_bad(m);
    const int what = fuzz_below(m, 16);
    dem_mesh mesh;
    dem_profile profile;
    dem_sieve_desc sieve = DEM_SIEVE_DESC;
    dem_motion motion = DEM_MOTION;
    dem_wall_loads loads;
    dem_pose pose;
    dem_wall wall;
    fuzz_say(m, "bad wall %d (%g)", what, (double)bad);
    wall.id = fuzz_below(m, 2) ? 0 : 999;
    mesh.vertex_count = 3; mesh.triangle_count = 1; mesh.vertices = v; mesh.triangles = t;
    profile.vertex_count = 3; profile.segment_count = 1; profile.vertices = v; profile.segments = t + 1;
    sieve.kind = DEM_SIEVE_WIRES;
    sieve.aperture = sieve.bar = DEM_R(1e-3);
    switch (what) {
    case 0: fuzz_id(m, dem_wall_plane_add(m->world, stuff, zero, zero).id); break;
    case 1: fuzz_id(m, dem_wall_plane_add(m->world, none, zero, up).id); break;
    case 2: fuzz_id(m, dem_wall_plane_add(m->world, stuff, dem_vec3_make((dem_real)NAN, 0, 0), up).id); break;
    case 3: fuzz_id(m, dem_wall_cylinder_add(m->world, stuff, zero, up, bad, 1).id); break;
    case 4: fuzz_id(m, dem_wall_cylinder_add(m->world, stuff, zero, zero, 1, 1).id); break;
    case 5: fuzz_id(m, dem_wall_mesh_add(m->world, stuff, &mesh).id); break;
    case 6: t[2] = 2; v[4] = (dem_real)NAN; fuzz_id(m, dem_wall_mesh_add(m->world, stuff, &mesh).id); break;
    case 7: fuzz_id(m, dem_wall_profile_add(m->world, stuff, &profile, DEM_EDGE_RESOLVED).id); break;
    case 8: fuzz_id(m, dem_wall_grains_add(m->world, stuff, 1, v, bad, 1).id); break;
    case 9: fuzz_id(m, dem_wall_grains_add(m->world, stuff, 1, v, 1, fuzz_below(m, 2) ? 2 : bad).id); break;
    case 10: sieve.aperture = bad; fuzz_id(m, dem_wall_sieve_add(m->world, stuff, &sieve).id); break;
    case 11:
        memcpy(&sieve.kind, unknown, sizeof sieve.kind);
        fuzz_id(m, dem_wall_sieve_add(m->world, stuff, &sieve).id);
        break;
    case 12: fuzz_result(m, dem_wall_motion_set(m->world, wall, &motion)); break;
    case 13: fuzz_result(m, dem_wall_pose_get(m->world, wall, &pose)); break;
    case 14: fuzz_result(m, dem_wall_loads_get(m->world, wall, &loads)); break;
    default:
        motion.kind = fuzz_below(m, 2) ? DEM_MOTION_USER : DEM_MOTION_ROTATING;   /* no function, no axis */
        fuzz_result(m, dem_wall_motion_set(m->world, fuzz_wall(m), &motion));
    }
}
static void fuzz_bad_rest(fuzz_machine *m) {
    const dem_material stuff = fuzz_material(m), none = {0};
    dem_real bad = fuzz_bad(m);
    const int what = fuzz_below(m, 18);
    dem_material_desc material = DEM_MATERIAL_DESC;
    dem_feed_desc feed;
    dem_outlet_desc outlet;
    dem_field_desc field;
    dem_slabs_desc slabs = DEM_SLABS_DESC;
    dem_pair pair;
    dem_field field_id;
    dem_field_data data;
    dem_mesh mesh;
    char path[200];
    if (m->impulses && (what == 1 || what == 4) && bad <= 0) bad = DEM_R(-1);   /* 0 is plastic */
    fuzz_say(m, "bad rest %d (%g)", what, (double)bad);
    memset(&feed, 0, sizeof feed);
    memset(&outlet, 0, sizeof outlet);
    memset(&field, 0, sizeof field);
    memset(&pair, 0, sizeof pair);
    feed.material = stuff;
    feed.class_count = 1;
    feed.radius[0] = DEM_R(1e-3);
    feed.amount[0] = 1;
    feed.rate = 10;
    feed.box = outlet.box = field.box = fuzz_box(m);
    field.cells[0] = field.cells[1] = field.cells[2] = 2;
    material.density = 2500; material.young = DEM_R(1e6); material.restitution = DEM_R(0.5);
    field_id.id = 99;
    switch (what) {
    case 0: material.density = bad; fuzz_id(m, dem_material_add(m->world, &material).id); break;
    case 1: material.restitution = bad; fuzz_id(m, dem_material_add(m->world, &material).id); break;
    case 2: material.friction = (dem_real)NAN; fuzz_id(m, dem_material_add(m->world, &material).id); break;
    case 3: fuzz_result(m, dem_pair_get(m->world, stuff, none, &pair)); break;
    case 4:
        if (dem_pair_get(m->world, stuff, stuff, &pair) == DEM_OK) pair.restitution = bad;
        fuzz_result(m, dem_pair_set(m->world, stuff, stuff, &pair));
        break;
    case 5: feed.class_count = fuzz_below(m, 2) ? 0 : 17; fuzz_id(m, dem_feed_add(m->world, &feed).id); break;
    case 6: feed.radius[0] = bad; fuzz_id(m, dem_feed_add(m->world, &feed).id); break;
    case 7: feed.rate = (double)NAN; fuzz_id(m, dem_feed_add(m->world, &feed).id); break;
    case 8: outlet.class_count = fuzz_below(m, 2) ? -1 : 17; fuzz_id(m, dem_outlet_add(m->world, &outlet).id); break;
    case 9: outlet.frame.id = 99; fuzz_id(m, dem_outlet_add(m->world, &outlet).id); break;
    case 10: field.cells[1] = fuzz_below(m, 2) ? 0 : 1 << 29; fuzz_id(m, dem_field_add(m->world, &field).id); break;
    case 11: fuzz_result(m, dem_field_get(m->world, field_id, &data)); break;
    case 12: fuzz_result(m, dem_world_step(m->world, -1)); break;
    case 13: fuzz_result(m, dem_world_run(m->world, fuzz_below(m, 2) ? (double)NAN : -1.0, 0, 0)); break;
    case 14: fuzz_path(".none", 'A', path); fuzz_result(m, dem_checkpoint_read(m->world, path)); break;
    case 15:
        snprintf(path, sizeof path, "%s/no/folder/here", fuzz_folder);
        fuzz_result(m, fuzz_below(m, 2) ? dem_checkpoint_write(m->world, path) : dem_vtp_write(m->world, path));
        break;
    case 16:
        slabs.count = fuzz_below(m, 2) ? 0 : 5000;
        if (dem_slabs_create(m->world, &slabs)) fuzz_fail("%c: %d slabs were made", m->name, slabs.count);
        fuzz_id(m, 0);
        break;
    default: fuzz_result(m, dem_mesh_parse(m->world, "bytes", &m->random, sizeof m->random, &mesh, 0));
    }
}
static void fuzz_bad_call(fuzz_machine *m) {
    const int what = fuzz_below(m, 3);
    m->must_fail = 1;
    if (what == 0) fuzz_bad_grain(m);
    else if (what == 1) fuzz_bad_wall(m);
    else fuzz_bad_rest(m);
}
/* Numbers that are finite and of the right sign, yet of no use. */
static void fuzz_unusable(fuzz_machine *m) {
    static const dem_real spot[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static int32_t ends[2] = {0, 1};
    const dem_material stuff = fuzz_material(m);
    const dem_vec3 x = fuzz_place(m);
    const int what = fuzz_below(m, 7);
    const dem_real small = (dem_real)(sizeof(dem_real) == 4 ? 1e-38 : 1e-305);
    const dem_real large = (dem_real)(sizeof(dem_real) == 4 ? 1e30 : 1e110);
    const int unknown[1] = {55};
    dem_real v[9];
    dem_profile profile;
    dem_edge_rule rule;
    dem_cluster_desc cluster = DEM_CLUSTER_DESC;
    memcpy(&rule, unknown, sizeof rule);
    fuzz_say(m, "unusable value %d", what);
    if (fuzz_avoids.unusable_values) { fuzz_say(m, " (avoided)"); return; }
    m->must_fail = 1;
    memcpy(v, spot, sizeof v);
    profile.vertex_count = 3; profile.segment_count = 1; profile.vertices = v; profile.segments = ends;
    cluster.count = 1; cluster.positions = spot; cluster.radius = DEM_R(1e-3);
    memcpy(&cluster.mass, unknown, sizeof cluster.mass);
    switch (what) {
    case 0: fuzz_id(m, (int32_t)dem_sphere_add(m->world, stuff, small, x).slot); break;
    case 1: fuzz_id(m, (int32_t)dem_sphere_add(m->world, stuff, large, x).slot); break;
    case 2: fuzz_id(m, dem_wall_profile_add(m->world, stuff, &profile, rule).id); break;
    case 3: fuzz_id(m, dem_shape_cluster_add(m->world, &cluster).id); break;
    case 4: fuzz_result(m, dem_spheres_add(m->world, stuff, -1, spot, 0, 0, DEM_R(1e-3))); break;
    case 5: fuzz_refused_count(m, dem_spheres_fill(m->world, stuff, DEM_R(1e-3), dem_region_make(fuzz_box(m)),
                                                   -1, 1)); break;
    default: fuzz_refused_count(m, dem_spheres_pack(m->world, stuff, DEM_R(1e-3), 0,
                                                    dem_region_make(fuzz_box(m)), -1));
    }
}
/* Null pointers where something is needed: answered, and nothing happens. */
static void fuzz_null(fuzz_machine *m) {
    const dem_material stuff = fuzz_material(m);
    const int what = fuzz_below(m, 20);
    dem_wall wall = fuzz_wall(m);
    fuzz_say(m, "null argument %d", what);
    if (fuzz_avoids.null_arguments) { fuzz_say(m, " (avoided)"); return; }
    m->must_fail = 1;
    switch (what) {
    case 0: fuzz_id(m, dem_material_add(m->world, 0).id); break;
    case 1: fuzz_result(m, dem_pair_get(m->world, stuff, stuff, 0)); break;
    case 2: fuzz_result(m, dem_pair_set(m->world, stuff, stuff, 0)); break;
    case 3: fuzz_result(m, dem_spheres_add(m->world, stuff, 1, 0, 0, 0, DEM_R(1e-3))); break;
    case 4: fuzz_id(m, dem_shape_cluster_add(m->world, 0).id); break;
    case 5: fuzz_id(m, dem_wall_mesh_add(m->world, stuff, 0).id); break;
    case 6: fuzz_id(m, dem_wall_profile_add(m->world, stuff, 0, DEM_EDGE_RESOLVED).id); break;
    case 7: fuzz_id(m, dem_wall_grains_add(m->world, stuff, 1, 0, DEM_R(1e-3), 1).id); break;
    case 8: fuzz_id(m, dem_wall_sieve_add(m->world, stuff, 0).id); break;
    case 9: fuzz_result(m, dem_wall_motion_set(m->world, wall, 0)); break;
    case 10: fuzz_result(m, dem_wall_pose_get(m->world, wall, 0)); break;
    case 11: fuzz_result(m, dem_wall_loads_get(m->world, wall, 0)); break;
    case 12: fuzz_id(m, dem_feed_add(m->world, 0).id); break;
    case 13: fuzz_id(m, dem_outlet_add(m->world, 0).id); break;
    case 14: fuzz_id(m, dem_field_add(m->world, 0).id); break;
    case 15: fuzz_result(m, dem_body_get(m->world, fuzz_body(m), 0)); break;
    case 16: fuzz_result(m, dem_body_set(m->world, fuzz_body(m), 0)); break;
    case 17: fuzz_result(m, dem_checkpoint_write(m->world, 0)); break;
    case 18: fuzz_result(m, dem_checkpoint_read(m->world, 0)); break;
    default:                                    /* no world at all */
        m->must_fail = 0;
        if (dem_world_step(0, 1) == DEM_OK || dem_world_run(0, 1, 0, 0) == DEM_OK || dem_candidates_rebuild(0) == DEM_OK ||
            dem_wall_plane_add(0, stuff, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1)).id ||
            dem_sphere_add(0, stuff, 1, dem_vec3_make(0, 0, 0)).slot || dem_vtp_write(0, "x") == DEM_OK ||
            dem_bodies_get(0).count || dem_world_time_get(0) > 0 || dem_contacts_get(0, 0, 0) > 0)
            fuzz_fail("%c: a null world was accepted", m->name);
        dem_world_hash_get(0);
        dem_world_report(0, 0);
        dem_world_destroy(0);
    }
}

/* ---- the list of calls ---- */
enum {
    FUZZ_SCENE = 1,                   /* belongs to the scene that a checkpoint asks for */
    FUZZ_BODY = 2,                    /* adds bodies */
    FUZZ_LOOK = 4,                    /* may be made in A alone */
    FUZZ_MEMORY = 8,                  /* one public call: when memory is refused, it can be made again */
    /* parts of the library, for programs about some of them */
    FUZZ_GRAINS = 16, FUZZ_SHAPES = 32, FUZZ_FLOW = 64, FUZZ_KEPT = 128, FUZZ_SLABS = 256, FUZZ_BAD = 512,
    FUZZ_EVERYTHING = FUZZ_GRAINS | FUZZ_SHAPES | FUZZ_FLOW | FUZZ_KEPT | FUZZ_SLABS | FUZZ_BAD
};
static const struct fuzz_kind { const char *name; void (*play)(fuzz_machine *m); int weight, flags; } fuzz_kinds[] = {
    {"material", fuzz_material_add, 3, FUZZ_SCENE | FUZZ_MEMORY | FUZZ_GRAINS},
    {"pair", fuzz_pair_set, 4, FUZZ_SCENE | FUZZ_GRAINS},
    {"ellipsoid", fuzz_ellipsoid, 3, FUZZ_SCENE | FUZZ_MEMORY | FUZZ_SHAPES},
    {"cluster", fuzz_cluster, 3, FUZZ_SCENE | FUZZ_MEMORY | FUZZ_SHAPES},
    {"polyhedron", fuzz_polyhedron, 3, FUZZ_SCENE | FUZZ_MEMORY | FUZZ_SHAPES},
    {"union", fuzz_union, 3, FUZZ_SCENE | FUZZ_MEMORY | FUZZ_SHAPES},
    {"polygon", fuzz_polygon, 3, FUZZ_SCENE | FUZZ_MEMORY | FUZZ_SHAPES},
    {"plane", fuzz_plane, 4, FUZZ_SCENE | FUZZ_MEMORY | FUZZ_GRAINS},
    {"cylinder", fuzz_cylinder, 3, FUZZ_SCENE | FUZZ_MEMORY | FUZZ_GRAINS},
    {"revolved", fuzz_revolved, 3, FUZZ_SCENE | FUZZ_MEMORY | FUZZ_GRAINS},
    {"profile", fuzz_profile, 3, FUZZ_SCENE | FUZZ_MEMORY | FUZZ_GRAINS},
    {"mesh", fuzz_mesh, 4, FUZZ_SCENE | FUZZ_MEMORY | FUZZ_GRAINS},
    {"grains wall", fuzz_grains_wall, 3, FUZZ_SCENE | FUZZ_MEMORY | FUZZ_GRAINS},
    {"sieve", fuzz_sieve, 4, FUZZ_SCENE | FUZZ_MEMORY | FUZZ_GRAINS},
    {"motion", fuzz_wall_motion, 5, FUZZ_SCENE | FUZZ_MEMORY | FUZZ_GRAINS},
    {"wall remove", fuzz_wall_remove, 2, FUZZ_SCENE | FUZZ_MEMORY | FUZZ_GRAINS},
    {"feed", fuzz_feed, 3, FUZZ_SCENE | FUZZ_MEMORY | FUZZ_FLOW},
    {"outlet", fuzz_outlet, 3, FUZZ_SCENE | FUZZ_MEMORY | FUZZ_FLOW},
    {"field", fuzz_field, 2, FUZZ_SCENE | FUZZ_MEMORY | FUZZ_FLOW},
    {"sphere", fuzz_sphere, 5, FUZZ_BODY | FUZZ_MEMORY | FUZZ_GRAINS},
    {"spheres", fuzz_spheres, 4, FUZZ_BODY | FUZZ_MEMORY | FUZZ_GRAINS},
    {"fill", fuzz_fill, 4, FUZZ_BODY | FUZZ_GRAINS},
    {"pack", fuzz_pack, 2, FUZZ_BODY | FUZZ_GRAINS},
    {"body", fuzz_body_add, 4, FUZZ_BODY | FUZZ_MEMORY | FUZZ_SHAPES},
    {"bodies", fuzz_bodies_add, 4, FUZZ_BODY | FUZZ_MEMORY | FUZZ_SHAPES},
    {"bodies fill", fuzz_bodies_fill, 3, FUZZ_BODY | FUZZ_SHAPES},
    {"body set", fuzz_body_set, 6, FUZZ_GRAINS},
    {"body remove", fuzz_body_remove, 4, FUZZ_GRAINS},
    {"joint", fuzz_joint_add, 6, FUZZ_MEMORY | FUZZ_GRAINS},
    {"joint change", fuzz_joint_change, 3, FUZZ_GRAINS},
    {"bodies remove", fuzz_bodies_remove, 2, FUZZ_GRAINS},
    {"step", fuzz_step, 30, FUZZ_EVERYTHING},
    {"run", fuzz_run, 6, FUZZ_EVERYTHING},
    {"search", fuzz_search, 4, FUZZ_MEMORY | FUZZ_GRAINS},
    {"check", fuzz_check, 2, FUZZ_GRAINS},
    {"look", fuzz_look_all, 4, FUZZ_LOOK | FUZZ_EVERYTHING},
    {"report", fuzz_report, 3, FUZZ_LOOK | FUZZ_GRAINS},
    {"resets", fuzz_resets, 3, FUZZ_GRAINS | FUZZ_FLOW},
    {"files", fuzz_files, 3, FUZZ_LOOK | FUZZ_GRAINS},
    {"replay", fuzz_replay, 3, FUZZ_GRAINS | FUZZ_KEPT},
    {"output", fuzz_output, 2, FUZZ_SCENE | FUZZ_GRAINS | FUZZ_KEPT},
    {"reals", fuzz_reals_set, 2, FUZZ_GRAINS},
    {"moldyn", fuzz_moldyn, 2, FUZZ_LOOK | FUZZ_GRAINS},
    {"checkpoint", 0, 10, FUZZ_KEPT},
    {"save", fuzz_save, 4, FUZZ_KEPT},
    {"restore", fuzz_restore, 6, FUZZ_KEPT},
    {"damaged", fuzz_damaged, 2, FUZZ_KEPT},
    {"slabs create", fuzz_slabs_create, 4, FUZZ_SLABS},
    {"slabs step", fuzz_slabs_step, 8, FUZZ_SLABS},
    {"slabs collect", fuzz_slabs_collect, 6, FUZZ_SLABS},
    {"bad", fuzz_bad_call, 12, FUZZ_BAD | FUZZ_LOOK},
    {"unusable", fuzz_unusable, 2, FUZZ_BAD},
    {"null", fuzz_null, 2, FUZZ_BAD | FUZZ_LOOK}
};
enum { FUZZ_KINDS = (int)(sizeof fuzz_kinds/sizeof *fuzz_kinds) };
static int fuzz_weights(int mask) {
    int k, sum = 0;
    for (k = 0; k < FUZZ_KINDS; k++) if (fuzz_kinds[k].flags & mask) sum += fuzz_kinds[k].weight;
    return sum;
}
static int fuzz_kind_of(unsigned char byte) { return byte%FUZZ_KINDS; }
/* A program of its own for every seed, about the parts in mask. Returns its size. */
static size_t fuzz_make(uint64_t seed, int mask, unsigned char bytes[FUZZ_BYTES]) {
    static const int begin[] = {7, 11, 20};     /* a plane, a mesh, a lattice of spheres */
    uint64_t random = seed*UINT64_C(0x2545F4914F6CDD1D) + 12345;
    const int sum = fuzz_weights(mask), calls = 8 + (int)(fuzz_next(&random)%32);
    int i, k;
    for (i = 0; i < 4*(calls + 1); i++) bytes[i] = (unsigned char)fuzz_next(&random);
    for (i = 1; i <= calls; i++) {
        int at = (int)(fuzz_next(&random)%(uint64_t)sum);
        for (k = 0; !(fuzz_kinds[k].flags & mask) || at >= fuzz_kinds[k].weight; k++)
            if (fuzz_kinds[k].flags & mask) at -= fuzz_kinds[k].weight;
        bytes[4*i] = (unsigned char)k;
    }
    for (i = 0; i < 3; i++) if (bytes[4*(i + 1) + 1] & 3) bytes[4*(i + 1)] = (unsigned char)begin[i];
    return (size_t)(4*(calls + 1));
}

/* ---- playing a program ---- */
typedef struct fuzz_play {
    fuzz_machine a, b;
    fuzz_memory memory_a, memory_b;
    const unsigned char *bytes;
    int calls, now;
    unsigned char done[FUZZ_CALLS];   /* was not refused */
    int quiet;                        /* nobody looks after every call: the hash alone is compared */
} fuzz_game;

static uint32_t fuzz_seed(const unsigned char *bytes) {
    return (uint32_t)bytes[0]*16777216u + (uint32_t)bytes[1]*65536u + (uint32_t)bytes[2]*256u + bytes[3];
}
static void fuzz_call(fuzz_machine *m, const unsigned char *bytes) {
    const struct fuzz_kind *kind = &fuzz_kinds[fuzz_kind_of(bytes[0])];
    m->random = fuzz_seed(bytes);
    m->answer = UINT64_C(14695981039346656037);
    m->failed = m->refusable = m->must_fail = 0;
    m->before = dem_world_hash_get(m->world);
    m->rebuilds = dem_counters_get(m->world).rebuilds;
    fuzz_calling = kind->play == fuzz_slabs_create || kind->play == fuzz_slabs_step ||
        kind->play == fuzz_slabs_collect ? 0 : m->world;
    kind->play(m);
    fuzz_calling = 0;
    if (m->memory->refused && fuzz_avoids.memory_refused_hash) m->refusable = 0;
    if (m->failed && m->refusable && dem_world_hash_get(m->world) != m->before)
        fuzz_fail("%c: %s was refused and changed the hash: %s", m->name, kind->name, dem_world_error_get(m->world));
    {
        const int domains = dem_counters_get(m->world).domains;
        if (domains > m->domains_most) m->domains_most = domains;
    }
    if (m->must_fail && !m->failed) fuzz_fail("%c: %s was accepted", m->name, kind->name);
    dem_world_error_get(m->world);                  /* read: a refusal does not keep runs from beginning */
}
/* A fresh world with the scene of a; with != 0: and what bodies were added, anyhow. */
static int fuzz_fresh(fuzz_game *g, fuzz_machine *f, int threads, int with) {
    int i, k;
    memset(f, 0, sizeof *f);
    f->name = 'F';
    f->memory = g->a.memory;
    f->memory->fill = (unsigned char)(f->memory->fill ^ 0x33);
    fuzz_open(f, g->a.desc_seed, threads);
    if (!f->world) return 0;
    f->random = 99;
    fuzz_material_add(f);
    for (k = 0; k < 1 + with; k++)
        for (i = 0; i < g->now; i++) {
            const unsigned char *bytes = g->bytes + 4*(i + 1);
            const int flags = fuzz_kinds[fuzz_kind_of(bytes[0])].flags;
            if (!g->done[i] || !(flags & (k ? FUZZ_BODY : FUZZ_SCENE))) continue;
            fuzz_call(f, bytes);
            if (!k && f->failed)
                fuzz_fail("F: %s was accepted in A and is refused in a fresh world: %s",
                          fuzz_kinds[fuzz_kind_of(bytes[0])].name, dem_world_error_get(f->world));
        }
    f->domains_most = g->a.domains_most;
    f->joints = g->a.joints;
    f->scene = g->a.scene; f->bodies_gone = g->a.bodies_gone; f->pairs_new = g->a.pairs_new;
    f->saved = g->a.saved; f->saved_scene = g->a.saved_scene; f->saved_hash = g->a.saved_hash;
    return 1;
}
static void fuzz_close(fuzz_machine *m) {
    if (m->slabs) dem_slabs_destroy(m->slabs);
    if (m->world) dem_world_destroy(m->world);
    m->slabs = 0;
    m->world = 0;
}
/* Written by A or B; read back by A, perhaps, and by a fresh world; then all go on side by side. */
static void fuzz_checkpoint(fuzz_game *g, const unsigned char *bytes) {
    fuzz_machine *a = &g->a, *b = &g->b, *writer, fresh;
    uint64_t random = fuzz_seed(bytes);
    const int which = (int)(fuzz_next(&random)%64), threads = 1 + (int)(fuzz_next(&random)%3);
    const int one_by_one = (int)(fuzz_next(&random)%2);
    char path[200];
    dem_result ra, rb, rf;
    int i;
    writer = which & 1 ? a : b;
    fuzz_say(a, "checkpoint: written by %c%s, read by a fresh world on %d threads%s%s, 20 steps\n", writer->name,
             which & 2 ? ", read back by A" : "", threads, which & 4 ? " with bodies of its own" : "",
             which & 8 ? ", which takes A's place" : "");
    if (fuzz_checkpoint_avoided(a)) { fuzz_say(a, "    (avoided)\n"); return; }
    fuzz_path(".ckpt", 'A', path);
    if (dem_checkpoint_write(writer->world, path) != DEM_OK) {
        if (a->unstable) { fuzz_say(a, "    (refused: %s)\n", dem_world_error_get(writer->world)); return; }
        fuzz_fail("%c: dem_checkpoint_write: %s", writer->name, dem_world_error_get(writer->world));
        return;
    }
    if (which & 2) {
        if (dem_checkpoint_read(a->world, path) != DEM_OK)
            fuzz_fail("A: does not read its own checkpoint: %s", dem_world_error_get(a->world));
        else fuzz_same(a, b, "when A has read the checkpoint back");
    }
    if (fuzz_wrong[0] || !fuzz_fresh(g, &fresh, threads, which >> 2 & 1 &
                                     !(fuzz_avoids.checkpoint_oriented_reader && a->shapes))) return;
    if (!fuzz_wrong[0] && dem_checkpoint_read(fresh.world, path) != DEM_OK)
        fuzz_fail("F: a fresh world with the same scene refuses the checkpoint: %s", dem_world_error_get(fresh.world));
    if (!fuzz_wrong[0]) fuzz_same(&fresh, b, "when a fresh world has read the checkpoint");
    for (i = 0; i < (one_by_one ? 20 : 2) && !fuzz_wrong[0]; i++) {
        ra = dem_world_step(a->world, one_by_one ? 1 : 10);
        rb = dem_world_step(b->world, one_by_one ? 1 : 10);
        rf = dem_world_step(fresh.world, one_by_one ? 1 : 10);
        if (ra != rb || ra != rf || (ra != DEM_OK && strcmp(dem_world_error_get(b->world), dem_world_error_get(fresh.world))))
            fuzz_fail("step %d after the checkpoint: A %s, B %s, F %s; %s", i, dem_result_name_get(ra), dem_result_name_get(rb),
                      dem_result_name_get(rf), dem_world_error_get(ra != DEM_OK ? a->world : fresh.world));
        if (ra == DEM_OK) a->bodies_gone = b->bodies_gone = 0;
        if (dem_counters_get(b->world).domains > a->domains_most)
            a->domains_most = b->domains_most = dem_counters_get(b->world).domains;
        fuzz_same(a, b, "some steps after the checkpoint");
        if (!fuzz_wrong[0]) fuzz_same(&fresh, b, "some steps after the checkpoint");
        a->unstable = b->unstable = ra == DEM_ERROR_UNSTABLE;
        if (ra != DEM_OK) break;
    }
    fresh.unstable = a->unstable;
    fresh.domains_most = a->domains_most;
    fresh.bodies_gone = a->bodies_gone;
    fresh.pairs_new = a->pairs_new;
    if (which & 8 && !fuzz_wrong[0]) {
        fresh.slabs = a->slabs;
        fresh.dealt = a->dealt;
        fresh.printing = a->printing;
        fresh.name = 'A';
        a->slabs = 0;
        fuzz_close(a);
        *a = fresh;
    } else fuzz_close(&fresh);
    remove(path);
}
static void fuzz_turn_of(fuzz_game *g, const unsigned char *bytes) {
    const struct fuzz_kind *kind = &fuzz_kinds[fuzz_kind_of(bytes[0])];
    fuzz_machine *a = &g->a, *b = &g->b;
    uint64_t random = fuzz_seed(bytes) ^ UINT64_C(0xabcdef);
    const int alone = (kind->flags & FUZZ_LOOK) && fuzz_next(&random)%3 == 0;
    const int probe = kind->play == fuzz_slabs_create && !fuzz_avoids.slabs_in_one_world;
    const long refuse = (kind->flags & FUZZ_MEMORY) && fuzz_next(&random)%3 == 0
        ? 1 + (long)(fuzz_next(&random)%8) : 0;
    if (!kind->play) { fuzz_checkpoint(g, bytes); return; }
    if (refuse && !fuzz_avoids.memory_refused) {
        a->memory->refused = 0;
        a->memory->refuse = refuse;
        fuzz_call(a, bytes);
        a->memory->refuse = 0;
        if (a->failed && a->memory->refused) {
            fuzz_say(a, " (request %ld got nothing)\n", refuse);
            a->memory->refused = 0;
            fuzz_call(a, bytes);
        }
        a->memory->refused = 0;
    } else fuzz_call(a, bytes);
    fuzz_say(a, alone ? " (in A alone)\n" : "\n");
    if (probe && a->slabs && !b->slabs) {        /* made and dropped again: A is what it was */
        dem_slabs_destroy(a->slabs);
        a->slabs = 0;
        fuzz_say(a, "    (destroyed again, and in B never made)\n");
    } else if (!alone) {
        fuzz_call(b, bytes);
        if (a->answer != b->answer || a->failed != b->failed)
            fuzz_fail("A and B answer differently to: %s (%s; %s)", kind->name,
                      a->failed ? dem_world_error_get(a->world) : "ok", b->failed ? dem_world_error_get(b->world) : "ok");
    }
    if (kind->flags & FUZZ_SCENE && !a->failed) { a->scene++; b->scene++; }
    g->done[g->now] = (unsigned char)!a->failed;
    if (!g->quiet) fuzz_same(a, b, "after the call");
    else if (dem_world_hash_get(a->world) != dem_world_hash_get(b->world)) fuzz_fail("A and B differ after the call: hash");
}
/* 0: all as it should be; else fuzz_wrong says what is not, and *at where. */
static int fuzz_run_program(const unsigned char *bytes, size_t size, int printing, int *at) {
    static fuzz_game g;
    fuzz_machine *both[2];
    int k;
    memset(&g, 0, sizeof g);
    fuzz_wrong[0] = 0;
    if (size < 4) return 0;
    g.bytes = bytes;
    g.calls = (int)(size/4) - 1;
    if (g.calls > FUZZ_CALLS) g.calls = FUZZ_CALLS;
    g.quiet = bytes[3]%3 == 0;
    both[0] = &g.a;
    both[1] = &g.b;
    g.memory_a.fill = 0x7f;
    g.memory_b.fill = 0x01;
    g.a.memory = &g.memory_a;
    g.b.memory = &g.memory_b;
    g.a.printing = printing;
    for (k = 0; k < 2; k++) {
        both[k]->name = (char)('A' + k);
        fuzz_open(both[k], fuzz_seed(bytes), 1 + k);
        both[k]->random = 99;
        if (both[k]->world) fuzz_material_add(both[k]);
    }
    fuzz_say(&g.a, "\n");
    for (g.now = 0; g.now < g.calls && !fuzz_wrong[0]; g.now++) {
        if (fuzz_avoids.going_on_after_unstable && g.a.unstable) break;
        fuzz_say(&g.a, "%3d ", g.now + 1);
        fuzz_turn_of(&g, bytes + 4*(g.now + 1));
    }
    if (!fuzz_wrong[0]) fuzz_same(&g.a, &g.b, "at the end");
    *at = g.now;
    for (k = 0; k < 2; k++) {
        char path[200];
        int i;
        fuzz_close(both[k]);
        remove(fuzz_path(".kept", both[k]->name, path));
        for (i = 0; i < 6; i++)
            remove(fuzz_path(i%3 == 0 ? ".out.vtp" : i%3 == 1 ? ".out.csv" : ".own.csv", i < 3 ? both[k]->name : 'F', path));
        if (both[k]->memory->live || both[k]->memory->wrong)
            fuzz_fail("%c: %ld blocks of memory were not given back, %d with another size", both[k]->name,
                      both[k]->memory->live, both[k]->memory->wrong);
    }
    return fuzz_wrong[0] != 0;
}

/* Leaves out calls for as long as it goes on failing. fails: 1 when a program does. */
static size_t fuzz_shrink(unsigned char *bytes, size_t size, int (*fails)(const unsigned char *bytes, size_t size)) {
    unsigned char less[FUZZ_BYTES];
    size_t chunk = size/8*4;
    while (chunk >= 4) {
        size_t from;
        int shorter = 0;
        for (from = 4; from < size;) {
            const size_t gone = from + chunk < size ? chunk : size - from;
            memcpy(less, bytes, from);
            memcpy(less + from, bytes + from + gone, size - from - gone);
            if (fails(less, size - gone)) {
                size -= gone;
                memcpy(bytes, less, size);
                shorter = 1;
            } else from += chunk;
        }
        if (!shorter || chunk > 4) chunk = chunk > 4 && chunk < 8 ? 4 : chunk/8*4;
    }
    return size;
}
static int fuzz_fails_here(const unsigned char *bytes, size_t size) {
    int at;
    return fuzz_run_program(bytes, size, 0, &at);
}
/* Runs the program of a seed; when it fails, prints the shortest one that does. 1: failed. */
static inline int fuzz_one(uint64_t seed, int mask) {
    unsigned char bytes[FUZZ_BYTES];
    size_t size = fuzz_make(seed, mask, bytes);
    int at;
    if (!fuzz_run_program(bytes, size, 0, &at)) return 0;
    printf("seed %llu of parts %d fails at call %d: %s\n", (unsigned long long)seed, mask, at, fuzz_wrong);
    size = fuzz_shrink(bytes, size, fuzz_fails_here);
    fuzz_run_program(bytes, size, 1, &at);
    printf("    => %s\n", fuzz_wrong);
    return 1;
}
#endif
