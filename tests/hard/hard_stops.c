/* Hard cases: runs that must fail. They stop at the step that caused it, say so in one sentence,
   and leave a world that can be looked at, saved, mended and run on. Each test names where its case
   or its number comes from. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"
#include <stdlib.h>

static const char *const saved = "build/tmp/stops.ckpt";
static const char *const picture = "build/tmp/stops.vtp";
static const double ball_size = 1e-3, odd_radius = 1.01e-3;        /* m */
static const double pi = 3.14159265358979323846;

static double nothing(void) { return HUGE_VAL - HUGE_VAL; }     /* no number */
static int fine(dem_real x) { return demi_finite(x); }

/* ---- what is asked of every world that has stopped ---- */

static char *file_text(const char *path, size_t *size) {
    FILE *f = fopen(path, "rb");
    char *text = 0;
    long n;
    *size = 0;
    if (!f) return 0;
    fseek(f, 0, SEEK_END);
    n = ftell(f);
    rewind(f);
    text = (char *)malloc((size_t)n + 1);
    if (text) {
        *size = fread(text, 1, (size_t)n, f);
        text[*size] = 0;
    }
    fclose(f);
    return text;
}
/* How many numbers of state are none; of other bodies than this one, in `others`. */
static int not_finite(const dem_world *world, dem_body but, int *others) {
    const dem_bodies b = dem_bodies_get(world);
    int i, k, all = 0;
    *others = 0;
    for (i = 0; i < b.count; i++)
        for (k = 0; k < 4; k++) {
            const int bad = !fine(b.positions[4*i + k]) + !fine(b.velocities[4*i + k]) +
                            !fine(b.spins[4*i + k]);
            all += bad;
            if (b.slots[i] + 1 != but.slot) *others += bad;
        }
    return all;
}
/* Looks at everything; saves as so many points, and reads back what was saved. lost: some number of
   a body is none, so nothing may be written over the last checkpoint. */
static void inspect_points(dem_world *world, int lost, int points) {
    const uint64_t hash = dem_world_hash_get(world);
    const int bodies = dem_bodies_get(world).count;
    const dem_body_counts balance = dem_body_counts_get(world);
    char words[60], *before, *after;
    size_t old_size, new_size;
    scene_report_has(world, "inserted = ");
    CHECK_EQ(balance.inserted, balance.present + balance.removed + balance.left);
    CHECK_EQ(balance.present, bodies);
    CHECK(dem_contacts_get(world, 0, 0) >= -1);
    if (!lost) {
        const dem_ledger l = dem_ledger_get(world);
        const dem_totals t = dem_totals_get(world);
        CHECK(demi_finite_double(l.kinetic) && demi_finite_double(l.residual));
        CHECK(demi_finite_double(t.kinetic) && demi_finite_double(t.angular[0]));
    }
    CHECK_EQ(dem_world_hash_get(world), hash);      /* looking changed nothing */
    before = file_text(saved, &old_size);
    if (lost) {
        CHECK_EQ(dem_checkpoint_write(world, saved), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "the run has blown up");
        after = file_text(saved, &new_size);
        CHECK_EQ(old_size, new_size);
        CHECK(before && after && !memcmp(before, after, old_size));
        free(after);
    } else {
        CHECK_EQ(dem_checkpoint_write(world, saved), DEM_OK);
        CHECK_EQ(dem_checkpoint_read(world, saved), DEM_OK);
        CHECK_EQ(dem_world_hash_get(world), hash);
    }
    free(before);
    CHECK_EQ(dem_vtp_write(world, picture), DEM_OK);
    after = file_text(picture, &new_size);
    snprintf(words, sizeof words, "NumberOfPoints=\"%d\"", points);
    CHECK_STR(after, words);
    free(after);
    remove(picture);
}
static void inspect(dem_world *world, int lost) {
    inspect_points(world, lost, dem_bodies_get(world).count);
}
static void says(const dem_world *world, const char *a, const char *b, const char *c,
                 const char *d) {
    const char *error = dem_world_error_get(world);
    CHECK_STR(error, a);
    CHECK_STR(error, b);
    CHECK_STR(error, c);
    CHECK_STR(error, d);
}

/* ---- functions of one's own that go wrong once they are told to ---- */

enum { LAW_NORMAL, LAW_TANGENT, LAW_MOMENT, FIELD_NAN, FIELD_INFINITE, FIELD_HUGE, BODY_FORCE,
      BODY_TORQUE, MOTION_PLACE, MOTION_SPEED, MOTION_TURN };
typedef struct trouble { int kind, on; } trouble;

static int is_odd(dem_real r) { return fabs((double)r - odd_radius) < 1e-3*ball_size; }
static void bad_law(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const trouble *t = (const trouble *)c->user;
    (void)memory;
    f->normal = c->kn*c->overlap + c->cn*c->closing_speed;
    if (!t->on || !c->wall || !is_odd(c->r_eff)) return;
    if (t->kind == LAW_NORMAL) f->normal = (dem_real)nothing();
    if (t->kind == LAW_TANGENT) f->tangent.x = (dem_real)nothing();
    if (t->kind == LAW_MOMENT) f->moment.y = (dem_real)HUGE_VAL;
}
static dem_vec3 bad_field(dem_vec3 x, dem_vec3 v, dem_real r, dem_real m, double time, void *user) {
    const trouble *t = (const trouble *)user;
    dem_vec3 f = at(0, 0, 0);
    (void)x; (void)v; (void)m; (void)time;
    if (!t->on || !is_odd(r)) return f;
    if (t->kind == FIELD_NAN) f.x = (dem_real)nothing();
    if (t->kind == FIELD_INFINITE) f.z = (dem_real)HUGE_VAL;
    if (t->kind == FIELD_HUGE) f.y = DEMI_SINGLE ? (dem_real)3e38 : (dem_real)1.7e308;
    return f;
}
static void bad_body_field(const dem_body_state *b, dem_body id, double time, dem_vec3 *f,
                           dem_vec3 *torque, void *user) {
    const trouble *t = (const trouble *)user;
    (void)id; (void)time;
    if (!t->on || !is_odd(b->radius)) return;
    if (t->kind == BODY_FORCE) f->z = (dem_real)nothing();
    if (t->kind == BODY_TORQUE) torque->z = (dem_real)HUGE_VAL;
}
static void bad_motion(double time, dem_pose *p, void *user) {
    const trouble *t = (const trouble *)user;
    int k;
    (void)time;
    p->position = p->velocity = p->spin = at(0, 0, 0);
    for (k = 0; k < 9; k++) p->rotation[k] = k%4 == 0;
    if (!t->on) return;
    if (t->kind == MOTION_PLACE) p->position.z = (dem_real)nothing();
    if (t->kind == MOTION_SPEED) p->velocity.x = (dem_real)HUGE_VAL;
    if (t->kind == MOTION_TURN) p->rotation[4] = (dem_real)nothing();
}
/* 2198 grains, in two domains, so that two threads have work: a block that presses on a floor, and
   beside it, on the floor, the odd one. */
static dem_world *crowd(trouble *t, int threads, dem_body *odd) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_motion motion = DEM_MOTION;
    dem_world *world;
    dem_material m;
    dem_wall floor;
    desc.threads = threads;
    desc.normal_law = DEM_NORMAL_LINEAR;
    desc.gravity = at(0, 0, -9.81);
    desc.dt = DEM_R(1e-5);
    desc.ledger = 1;
    desc.orientations = t->kind <= LAW_MOMENT;
    if (t->kind <= LAW_MOMENT) { desc.law = bad_law; desc.law_user = t; }
    else if (t->kind <= FIELD_HUGE) { desc.force = bad_field; desc.force_user = t; }
    else if (t->kind <= BODY_TORQUE) { desc.body_force = bad_body_field; desc.force_user = t; }
    world = dem_world_create(&desc);
    m = scene_material(world, 1e5, 0.5, 0.3, 0);
    floor = dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
    motion.kind = DEM_MOTION_USER;
    motion.function = bad_motion;
    motion.user = t;
    if (t->kind >= MOTION_PLACE) CHECK_EQ(dem_wall_motion_set(world, floor, &motion), DEM_OK);
    scene_block(world, m, 13, 13, 13, ball_size, 0, 0.1, 1);
    *odd = dem_sphere_add(world, m, (dem_real)odd_radius, at(0.01, -0.003, odd_radius*0.99));
    return world;
}
enum { GOOD = 10, MORE = 8 };                   /* steps before it goes wrong, and after */

/* The run that never goes wrong, for comparison. */
static uint64_t crowd_hash(int kind, int threads) {
    trouble t;
    dem_body odd;
    dem_world *world;
    uint64_t hash;
    t.kind = kind;
    t.on = 0;
    world = crowd(&t, threads, &odd);
    CHECK_EQ(scene_step(world, GOOD + MORE), DEM_OK);
    CHECK_EQ(dem_counters_get(world).domains, 2);
    hash = dem_world_hash_get(world);
    dem_world_destroy(world);
    return hash;
}
/* A force that is no number, with so many threads; answers the hash of the world that stopped. */
static uint64_t force_goes_wrong(int kind, int threads, char sentence[600]) {
    trouble t;
    dem_body odd;
    dem_world *world;
    uint64_t hash, stopped;
    dem_body_state s;
    char words[40];
    int others, all;
    t.kind = kind;
    t.on = 0;
    hash = crowd_hash(kind, 3 - threads);
    world = crowd(&t, threads, &odd);
    CHECK_EQ(scene_step(world, GOOD), DEM_OK);
    CHECK_EQ(dem_checkpoint_write(world, saved), DEM_OK);
    t.on = 1;
    CHECK_EQ(dem_world_step(world, 5), DEM_ERROR_UNSTABLE);
    CHECK_EQ(dem_world_steps_get(world), GOOD + 1);
    CHECK_REL(dem_world_time_get(world), (GOOD + 1)*(double)DEM_R(1e-5), 1e-12);
    snprintf(sentence, 600, "%s", dem_world_error_get(world));
    snprintf(words, sizeof words, "body %u:", odd.slot);
    says(world, "dem_world_step: step 11,", words, "a finite number",
         "user-defined law, force field or motion divided by zero");
    all = not_finite(world, odd, &others);
    CHECK(all > 0);
    CHECK_EQ(others, 0);                        /* the odd one alone, that touches no other grain */
    s = scene_state(world, odd);
    CHECK(fine(s.position.x) && fine(s.position.y) && fine(s.position.z));
    CHECK_NEAR(s.position.z, odd_radius*0.99, 0.02*ball_size);  /* it stands where it was pushed */
    stopped = dem_world_hash_get(world);
    inspect(world, 1);
    CHECK_EQ(dem_world_step(world, 1), DEM_ERROR_UNSTABLE);     /* not mended: it stays stopped */
    t.on = 0;
    CHECK_EQ(dem_checkpoint_read(world, saved), DEM_OK);
    CHECK_EQ(scene_step(world, MORE), DEM_OK);
    CHECK_EQ(dem_world_hash_get(world), hash);      /* as if it had never happened */
    t.on = 1;
    CHECK_EQ(dem_world_step(world, 1), DEM_ERROR_UNSTABLE);
    CHECK_EQ(dem_body_remove(world, odd), DEM_OK);              /* or without the grain */
    CHECK_EQ(scene_step(world, MORE), DEM_OK);
    CHECK_EQ(not_finite(world, odd, &others), 0);
    dem_world_destroy(world);
    return stopped;
}
static void motion_goes_wrong(int kind, int threads) {
    trouble t;
    dem_body odd;
    dem_world *world;
    int others;
    t.kind = kind;
    t.on = 0;
    world = crowd(&t, threads, &odd);
    CHECK_EQ(scene_step(world, GOOD), DEM_OK);
    CHECK_EQ(dem_checkpoint_write(world, saved), DEM_OK);
    t.on = 1;
    CHECK_EQ(dem_world_step(world, 5), DEM_ERROR_UNSTABLE);
    CHECK_EQ(dem_world_steps_get(world), GOOD + 1);
    says(world, "dem_world_step: step 11: the motion of wall 1", "not finite", "at 0.00011 s",
         "check the motion");
    CHECK_EQ(not_finite(world, odd, &others), 0);
    scene_report_has(world, "wall 1");
    t.on = 0;
    CHECK_EQ(dem_checkpoint_read(world, saved), DEM_OK);
    CHECK_EQ(scene_step(world, MORE), DEM_OK);
    CHECK_EQ(dem_world_hash_get(world), crowd_hash(kind, threads));
    CHECK_EQ(dem_checkpoint_read(world, saved), DEM_OK);
    t.on = 1;
    CHECK_EQ(dem_world_step(world, 1), DEM_ERROR_UNSTABLE);
    inspect(world, 0);                          /* the wall stands where it stood: it can be saved */
    t.on = 0;                                   /* and goes on, with the floor still there */
    CHECK_EQ(scene_step(world, MORE), DEM_OK);
    CHECK_EQ(not_finite(world, odd, &others), 0);
    dem_world_destroy(world);
}

/* ---- overlaps beyond a radius ---- */

/* A grain, or two that meet head on, whose spring would be pressed by 2 radii: w sin(t w)/w = R is
   passed at t = asin(1/2)/w, w = sqrt(k/m). */
static void press_through(int pair) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc d = scene_stuff(1e5, 1, 0, 0);
    dem_coefficients k;
    dem_contact_info c;
    dem_world *world;
    dem_material m;
    dem_body b[2];
    double w, when;
    int i, others;
    const double speed = 1;
    desc.threads = 1;
    desc.ledger = 1;
    desc.normal_law = DEM_NORMAL_LINEAR;
    desc.dt = DEM_R(2.1e-5);
    d.stiffness = DEM_R(2.5);
    world = dem_world_create(&desc);
    m = dem_material_add(world, &d);
    if (!pair) dem_wall_plane_add(world, m, at(0, 0, -ball_size), at(0, 0, 1));
    else scene_move(world, dem_sphere_add(world, m, DEM_R(ball_size), at(0, 0, -2*ball_size)),
                    at(0, 0, speed/2), at(0, 0, 0));
    b[0] = dem_sphere_add(world, m, DEM_R(ball_size), at(0, 0, 0));
    dem_coefficients_get(world, m, m, DEM_R(ball_size), pair ? DEM_R(ball_size) : 0, &k);
    w = sqrt((double)k.kn/(double)k.m_eff);
    scene_move(world, b[0], at(0, 0, -2*ball_size*w + (pair ? speed/2 : 0)), at(0, 0, 0));
    when = asin(0.5)/w;
    CHECK_EQ(dem_world_step(world, 2000), DEM_ERROR_UNSTABLE);
    /* the step ends less than one step after; the phase error (w dt)^2/24 is 1e-5 of it */
    CHECK_NEAR(dem_world_time_get(world) - (double)desc.dt/2, when, 0.51*(double)desc.dt);
    if (!pair) says(world, "body 1 overlaps wall 1 by 1.0", "must be below 1", "too fast for dt",
                    "too soft");
    else says(world, "bodies 1 and 2 overlap by 1.0", "must be below 1", "too fast for dt", "too soft");
    CHECK_EQ(not_finite(world, b[0], &others), 0);
    CHECK_EQ(dem_contacts_get(world, &c, 1), 1);
    CHECK((double)c.overlap > ball_size && (double)c.overlap < 1.1*ball_size);
    CHECK_REL(dem_ledger_get(world).kinetic + dem_ledger_get(world).elastic -
              dem_ledger_get(world).inserted, dem_ledger_get(world).residual, 1e-3);
    inspect(world, 0);
    CHECK_EQ(dem_world_step(world, 1), DEM_ERROR_UNSTABLE);
    scene_move(world, b[0], at(0, 0, 0), at(0, 0, 0));
    { /* mended: back to where they just touch, and slower by 10 */
        dem_body_state s = scene_state(world, b[0]);
        s.position = at(0, 0, (double)s.position.z + 1.5*ball_size);
        s.velocity = at(0, 0, -0.1);
        CHECK_EQ(dem_body_set(world, b[0], &s), DEM_OK);
    }
    dem_overlap_max_reset(world);
    for (i = 0; i < 3; i++) CHECK_EQ(scene_step(world, 20), DEM_OK);
    CHECK((double)dem_counters_get(world).overlap_max < 1);
    dem_world_destroy(world);
}

/* Bodies of every kind, far too fast for soft matter, on every wall that has an inside. */
static void shapes_too_fast(int shape, int wall) {
    static const dem_real balls[6] = {DEM_R(-1e-3), 0, 0, DEM_R(1e-3), 0, 0};
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_cluster_desc two = DEM_CLUSTER_DESC;
    dem_world *world;
    dem_material m;
    dem_shape kind;
    dem_body b;
    int others;
    kind.id = 0;
    desc.threads = 1;
    desc.ledger = 1;
    desc.dt = DEM_R(1e-6);                      /* a tenth of the smallest half axis */
    world = dem_world_create(&desc);
    m = scene_material(world, 1e4, 0.9, 0.3, 0);
    two.count = 2;
    two.positions = balls;
    two.radius = DEM_R(1e-3);
    if (shape == 1) kind = dem_shape_cluster_add(world, &two);
    if (shape == 2) kind = dem_shape_ellipsoid_add(world, at(5e-4, 5e-4, 5e-3));
    if (shape == 3) kind = dem_shape_ellipsoid_add(world, at(3e-3, 3e-3, 5e-4));
    if (wall == 0) dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
    else dem_wall_cylinder_add(world, m, at(0, 0, 0.05), at(0, 1, 0), DEM_R(0.05), 1);
    b = shape ? dem_body_add(world, m, kind, at(0, 0, 0.01), dem_quat_make(1, 0, 0, 0))
              : dem_sphere_add(world, m, DEM_R(1e-3), at(0, 0, 0.01));
    scene_move(world, b, at(0, 0, -100), at(0, 0, 0));
    CHECK_EQ(dem_world_step(world, 1000), DEM_ERROR_UNSTABLE);
    /* 1 cm less the body's own height, at 100 m/s, is 0.05 to 0.1 ms; then the overlap grows */
    CHECK(dem_world_time_get(world) > 4e-5 && dem_world_time_get(world) < 2e-4);
    says(world, "body 1 overlaps wall 1 by", "of its radius, must be below 1", "too fast for dt = ",
         "too soft");
    CHECK_EQ(not_finite(world, b, &others), 0);
    inspect_points(world, 0, shape == 1 ? 2 : 1);
    dem_world_destroy(world);
}

/* ---- passing through ---- */

/* One triangle at z = 0 about the origin. */
static dem_wall facet_add(dem_world *world, dem_material m, double s) {
    dem_real v[9];
    int32_t t[3] = {0, 1, 2};
    dem_mesh mesh;
    memset(v, 0, sizeof v);
    v[0] = v[1] = v[4] = v[6] = (dem_real)-s;
    v[3] = v[7] = (dem_real)(2*s);
    mesh.vertex_count = 3;
    mesh.triangle_count = 1;
    mesh.vertices = v;
    mesh.triangles = t;
    return dem_wall_mesh_add(world, m, &mesh);
}
/* references.md 5.13 (Chrono's utest_DEM_ballistic): R .5 m at 1e4 m/s from z = 4 m, g 980 m/s2, a
   spring of 1e11 N/m, one triangle. */
static dem_world *ballistic(double mass, double dt, int allow, dem_body *ball) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc d = scene_stuff(1e11, 1, 0, 0);
    dem_world *world;
    dem_material m;
    desc.threads = 1;
    desc.ledger = 1;
    desc.normal_law = DEM_NORMAL_LINEAR;
    desc.gravity = at(0, 0, -980);
    desc.dt = (dem_real)dt;
    desc.allow_large_dt = allow;
    d.density = (dem_real)(mass*6/pi);           /* a ball of 1 m across */
    d.stiffness = DEM_R(1e11);
    world = dem_world_create(&desc);
    m = dem_material_add(world, &d);
    facet_add(world, m, 10);
    *ball = dem_sphere_add(world, m, DEM_R(0.5), at(0, 0, 4));
    scene_move(world, *ball, at(0, 0, -1e4), at(0, 0, 0));
    return world;
}
/* Steps until the ball touches; s. */
static double ballistic_hit(dem_world *world) {
    while (dem_world_time_get(world) < 1e-3 && scene_step(world, 1) == DEM_OK)
        if (dem_counters_get(world).wall_contacts) return dem_world_time_get(world);
    return 0;
}

/* ---- thrown: faster than a step can see ---- */

enum { THROUGH_GRAIN, THROUGH_FACET, THROUGH_PLANE, OBSTACLES };
static void thrown(int obstacle, int late) {
    char words[60];
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material m;
    dem_body ball;
    uint64_t hash;
    int others;
    desc.threads = 1;
    desc.ledger = 1;
    desc.dt = DEM_R(1e-6);
    desc.impact_speed = 1;
    world = dem_world_create(&desc);
    m = scene_material(world, 1e6, 0.5, 0.3, 0);
    if (obstacle == THROUGH_GRAIN)
        dem_sphere_add(world, m, DEM_R(ball_size), at(0, 0, -2*ball_size));
    if (obstacle == THROUGH_FACET) facet_add(world, m, 1);
    if (obstacle == THROUGH_PLANE) dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
    ball = dem_sphere_add(world, m, DEM_R(ball_size), at(0, 0, 1.5*ball_size));
    if (late) CHECK_EQ(scene_step(world, late), DEM_OK);
    scene_move(world, ball, at(0, 0, -5000), at(0, 0, 0));      /* 5 radii a step */
    hash = dem_world_hash_get(world);
    CHECK_EQ(dem_world_step(world, 3), DEM_ERROR_TIME_STEP);
    CHECK_EQ(dem_world_steps_get(world), late);
    snprintf(words, sizeof words, "body %u, the fastest, is at 5e+03 m/s and may", ball.slot);
    says(world, words, "moves 5 radii of the smallest grain (0.001 m) in a step of 1e-06 s, must be "
         "at most 1", "it would pass through others and walls undetected", "use at most 2e-08 s");
    CHECK_EQ(dem_world_hash_get(world), hash);      /* nothing moved: it stands before the obstacle */
    CHECK_NEAR(scene_state(world, ball).position.z, 1.5*ball_size, 1e-9);
    CHECK_EQ(not_finite(world, ball, &others), 0);
    inspect(world, 0);
    scene_move(world, ball, at(0, 0, -1), at(0, 0, 0));         /* mended: as fast as was assumed */
    CHECK_EQ(scene_step(world, 2000), DEM_OK);
    CHECK(dem_counters_get(world).overlap_max > 0);             /* it met, and did not pass */
    CHECK(scene_state(world, ball).velocity.z > DEM_R(-0.51));
    dem_world_destroy(world);
}

/* ---- explosions ---- */

/* 2197 grains of glass, pressed by 3 % of a radius, whose step is so many times the largest that
   is advised; answers the hash, and where it stopped. */
static uint64_t explode(double factor, int threads, int allow, dem_result *result,
                        char sentence[600], uint64_t *steps) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material m;
    dem_advice a;
    dem_body none = {0, 0};
    uint64_t hash;
    int others, k;
    desc.threads = threads;
    desc.ledger = 1;
    desc.impact_speed = DEM_R(0.1);
    for (k = 0; ; k++) {
        world = dem_world_create(&desc);
        m = scene_material(world, 1e9, 0.5, 0.3, 0);
        scene_block(world, m, 13, 13, 13, ball_size, 0, 0.1, 1);
        if (k) break;
        CHECK_EQ(dem_step_advice_get(world, &a), DEM_OK);
        dem_world_destroy(world);
        desc.dt = (dem_real)(factor*(double)a.dt_max);
        desc.allow_large_dt = allow;
    }
    *result = dem_world_step(world, 300);
    snprintf(sentence, 600, "%s", *result == DEM_OK ? "" : dem_world_error_get(world));
    *steps = dem_world_steps_get(world);
    hash = dem_world_hash_get(world);
    CHECK_EQ(not_finite(world, none, &others), 0);
    inspect(world, 0);
    dem_world_destroy(world);
    return hash;
}

/* ---- a callback that stops ---- */

static int halt(const dem_world *world, double done, double left, void *user) {
    (void)world; (void)done; (void)left;
    return ++*(int *)user == 1;                 /* once */
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("a law, field or torque that returns NaN or infinity stops the run in that step; it "
         "resumes from the last checkpoint") {
        int kind;
        for (kind = LAW_NORMAL; kind <= BODY_TORQUE; kind++) {
            char sentence[2][600];
            uint64_t hash;
            if (kind == FIELD_HUGE) continue;
            hash = force_goes_wrong(kind, 1, sentence[0]);
            CHECK_EQ(force_goes_wrong(kind, 2, sentence[1]), hash);
            CHECK(!strcmp(sentence[0], sentence[1]));
        }
    }
    TEST("a force of 1.7e308 N stops the run in the step in which it acts, and the run continues "
         "without that grain") {
        trouble t;
        dem_body odd;
        dem_world *world;
        int others;
        t.kind = FIELD_HUGE;
        t.on = 0;
        world = crowd(&t, 1, &odd);
        CHECK_EQ(scene_step(world, GOOD), DEM_OK);
        CHECK_EQ(dem_checkpoint_write(world, saved), DEM_OK);
        t.on = 1;
        CHECK_EQ(dem_world_step(world, 5), DEM_ERROR_UNSTABLE);
        /* 3e38 is not beyond what forces are tested for; the speed it gives is */
        CHECK_EQ(dem_world_steps_get(world), GOOD + (DEMI_SINGLE ? 2 : 1));
        says(world, "body 2198: its", "force", "user-defined law, force field or motion", "");
        CHECK(not_finite(world, odd, &others) > 0);
        CHECK_EQ(others, 0);
        inspect(world, 1);
        CHECK_EQ(dem_body_remove(world, odd), DEM_OK);
        CHECK_EQ(scene_step(world, MORE), DEM_OK);
        CHECK_EQ(not_finite(world, odd, &others), 0);
        dem_world_destroy(world);
    }
    TEST("a wall motion that returns NaN stops the run in that step with the wall and time; the "
         "last checkpoint resumes it") {
        int kind;
        for (kind = MOTION_PLACE; kind <= MOTION_TURN; kind++) {
            motion_goes_wrong(kind, 1);
            motion_goes_wrong(kind, 2);
        }
    }
    TEST("dem_body_set rejects a position, speed, spin or orientation that is NaN, infinite or "
         "beyond 1e15 m, in mid-run") {
        static const double bad[3] = {0, HUGE_VAL, -2e15};
        trouble t;
        dem_body odd;
        dem_world *world;
        uint64_t hash;
        int field, k;
        t.kind = LAW_NORMAL;
        t.on = 0;
        world = crowd(&t, 1, &odd);
        CHECK_EQ(scene_step(world, GOOD), DEM_OK);
        hash = dem_world_hash_get(world);
        for (field = 0; field < 13; field++)
            for (k = 0; k < 3; k++) {
                const double v = k ? bad[k] : nothing();
                dem_body_state s = scene_state(world, odd);
                dem_real *x[4];
                x[0] = &s.position.x; x[1] = &s.velocity.x; x[2] = &s.spin.x;
                x[3] = &s.orientation.w;
                if (k == 2 && field >= 3) continue;
                if (field < 9) x[field/3][field%3] = (dem_real)v;
                else x[3][field - 9] = (dem_real)v;
                CHECK_EQ(dem_body_set(world, odd, &s), DEM_ERROR_ARGUMENT);
                says(world, "dem_body_set: ", "finite", "", "");
                CHECK_EQ(dem_world_hash_get(world), hash);
            }
        CHECK_EQ(scene_step(world, MORE), DEM_OK);
        CHECK_EQ(dem_world_hash_get(world), crowd_hash(t.kind, 1));
        dem_world_destroy(world);
    }
    TEST("a grain that its spring cannot hold stops the run when its overlap passes one radius, "
         "at asin(1/2)/w") {
        press_through(0);
        press_through(1);
    }
    TEST("spheres, clusters, needles and discs at 100 m/s on matter of 1e4 Pa stop the run with "
         "grain and wall named") {
        int shape, wall;
        for (shape = 0; shape < 4; shape++)
            for (wall = 0; wall < 2; wall++) shapes_too_fast(shape, wall);
    }
    TEST("Chrono's ballistic test: a 0.5 m ball at 1e4 m/s bounces off a triangle, or the run "
         "stops where it would pass through") {
        /* sqrt(v^2 + 2 g (z0 - R)) - v over g; a step of 1e-6 s is what this is seen with */
        const double when = (sqrt(1e8 + 2*980*3.5) - 1e4)/980;
        dem_finding found[4];
        dem_body ball;
        dem_world *world = ballistic(1, 4e-7, 0, &ball);
        int n, i, told = 0;
        CHECK_NEAR(ballistic_hit(world) - 2e-7, when, 2.1e-7);
        CHECK_EQ(scene_step(world, 500), DEM_OK);
        /* elastic: off by (w dt)^2/8 at most, w dt = .126, where a step begins or ends it */
        CHECK_REL(scene_state(world, ball).velocity.z, 1e4, 2e-3);
        CHECK((double)dem_counters_get(world).overlap_max < 0.1);
        dem_world_destroy(world);
        world = ballistic(1, 1e-6, 0, &ball);
        CHECK_EQ(dem_world_step(world, 1000), DEM_ERROR_TIME_STEP);
        says(world, "dt is 1e-06 s", "must be at most t_c/20 = 4.9", "radius 0.5 m, on wall 1",
             "use dt = 0, a softer material or a smaller dt");
        CHECK_EQ(dem_world_steps_get(world), 0);
        inspect(world, 0);
        dem_world_destroy(world);
        /* 1000 kg: v/w = 1 m, so that the middle of the ball comes to the triangle */
        world = ballistic(1000, 1e-6, 0, &ball);
        n = dem_world_check(world, found, 4);
        for (i = 0; i < n && i < 4; i++)
            told |= found[i].severity >= DEM_SEVERITY_WARNING &&
                    strstr(found[i].text, "overlap by 1.4 of their radius at 1e+04 m/s") != 0;
        CHECK(told);
        CHECK_NEAR(ballistic_hit(world) - 5e-7, when, 5.1e-7);
        CHECK_EQ(dem_world_step(world, 1000), DEM_ERROR_UNSTABLE);
        says(world, "body 1 overlaps wall 1 by 1.", "must be below 1", "too fast for dt", "too soft");
        dem_world_destroy(world);
    }
    TEST("a grain moving 5 radii per step towards a grain, triangle or plane stops the run before "
         "it moves") {
        int obstacle;
        for (obstacle = 0; obstacle < OBSTACLES; obstacle++) {
            thrown(obstacle, 0);
            thrown(obstacle, 17);
        }
    }
    TEST("2197 pressed grains with a step 5 or 20 times too large diverge and stop in the same "
         "step for 1 and 2 threads") {
        static const double factor[2] = {5, 20};
        char sentence[2][600];
        dem_result result[2];
        uint64_t hash[2], steps[2];
        int i, k;
        for (i = 0; i < 2; i++) {
            for (k = 0; k < 2; k++)
                hash[k] = explode(factor[i], k + 1, 1, &result[k], sentence[k], &steps[k]);
            CHECK_EQ(result[0], DEM_ERROR_UNSTABLE);
            CHECK_EQ(result[1], DEM_ERROR_UNSTABLE);
            CHECK_EQ(hash[0], hash[1]);
            CHECK_EQ(steps[0], steps[1]);
            CHECK(steps[0] > 0 && steps[0] < 20);
            CHECK(!strcmp(sentence[0], sentence[1]));
            CHECK_STR(sentence[0], "overlap by");
            CHECK_STR(sentence[0], "must be below 1");
            CHECK_STR(sentence[0], "too fast for dt = ");
        }
        explode(0.9, 1, 0, &result[0], sentence[0], &steps[0]);
        CHECK_EQ(result[0], DEM_ERROR_TIME_STEP);   /* one contact bears it, several do not */
        CHECK_EQ(steps[0], 0);
        CHECK_STR(sentence[0], "body ");
        /* what limits dt is rotation, which four contacts resist inside the block and on its faces alike */
        CHECK(strstr(sentence[0], "is pressed by 6 contacts with overlaps up to 0.03 of its radius") ||
              strstr(sentence[0], "is pressed by 5 contacts with overlaps up to 0.03 of its radius"));
        CHECK_STR(sentence[0], "use dt = 0, a smaller dt, or less overlap");
    }
    TEST("a grain that begins 1.02 radii deep in a grain or wall stops the run before it moves; "
         "at 0.98 it runs") {
        static const dem_real centre[3] = {0, 0, 0};
        int kind, wall, deep;
        for (kind = 0; kind < 3; kind++)
            for (wall = 0; wall < 2; wall++)
                for (deep = 0; deep < 2; deep++) {
                    const double gone = deep ? 1.02 : 0.98;
                    dem_world_desc desc = DEM_WORLD_DESC;
                    dem_cluster_desc one = DEM_CLUSTER_DESC;
                    dem_shape shape = {0};
                    dem_material m;
                    dem_world *world;
                    dem_body a, b = {0, 0};
                    dem_result result;
                    desc.threads = 1;
                    desc.dt = DEM_R(1e-6);
                    world = dem_world_create(&desc);
                    m = scene_material(world, 1e6, 0.5, 0, 0);
                    one.count = 1;
                    one.positions = centre;
                    one.radius = DEM_R(1e-3);
                    if (kind == 1) shape = dem_shape_ellipsoid_add(world, at(1e-3, 1e-3, 1e-3));
                    if (kind == 2) shape = dem_shape_cluster_add(world, &one);
                    a = kind ? dem_body_add(world, m, shape, at(0, 0, 0), dem_quat_make(1, 0, 0, 0))
                             : dem_sphere_add(world, m, DEM_R(1e-3), at(0, 0, 0));
                    if (wall) dem_wall_plane_add(world, m, at(0, 0, -1e-3*(1 - gone)), at(0, 0, 1));
                    else if (kind)
                        b = dem_body_add(world, m, shape, at(0, 0, 1e-3*(2 - gone)),
                                         dem_quat_make(1, 0, 0, 0));
                    else b = dem_sphere_add(world, m, DEM_R(1e-3), at(0, 0, 1e-3*(2 - gone)));
                    result = dem_world_step(world, 1);
                    CHECK_EQ(result, deep ? DEM_ERROR_UNSTABLE : DEM_OK);
                    if (deep) {
                        says(world, "step 0", wall ? "body 1 overlaps wall 1 by 1.02 of its radius"
                                                   : "bodies 1 and 2 overlap by 1.02 of",
                             "must be below 1", "started in");
                        CHECK_EQ(dem_world_steps_get(world), 0);
                        CHECK_NEAR(scene_state(world, a).position.z, 0, 0);
                        if (!wall) CHECK_NEAR(scene_state(world, b).velocity.z, 0, 0);
                    }
                    dem_world_destroy(world);
                }
    }
    TEST("a run stopped by its progress function stops between two steps and continues with the "
         "same bits") {
        trouble t;
        dem_body odd;
        dem_world *world;
        uint64_t hash;
        int calls = 0, total;
        t.kind = FIELD_NAN;
        t.on = 0;
        world = crowd(&t, 2, &odd);
        CHECK_EQ(dem_world_run(world, 20, halt, &calls), DEM_ERROR_STOPPED);
        CHECK_EQ(calls, 1);
        says(world, "dem_world_run: ", "stopped by the progress function at", "", "");
        total = (int)dem_world_steps_get(world);
        CHECK(total > 0);
        inspect(world, 0);
        CHECK_EQ(dem_world_run(world, 20*(double)DEM_R(1e-5), 0, 0), DEM_OK);
        CHECK_EQ(dem_world_steps_get(world), total + 20);
        hash = dem_world_hash_get(world);
        dem_world_destroy(world);
        world = crowd(&t, 1, &odd);
        CHECK_EQ(scene_step(world, total + 20), DEM_OK);
        CHECK_EQ(dem_world_hash_get(world), hash);
        dem_world_destroy(world);
    }
    remove(saved);
    return test_end();
}
