/* Changes of the scene in mid-run: the set of effects in force follows. What an effect adds when it
   comes in mid-run is what it adds in a world that had it from the start and was put together from
   the same state; what it adds ends when it goes. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const char *const saved = "build/tmp/changes.ckpt";
static double eps(void) { return sizeof(dem_real) == 8 ? 2.2e-16 : 1.2e-7; }
static const double ball_size = 1e-3, tick = 2e-6; /* m, s */
static const double pi = 3.14159265358979323846;

enum { BEFORE = 12, AFTER = 12 };               /* steps */
typedef enum change { FRICTION_ON, FRICTION_OFF, FRICTION_AGAIN, ROLLING_ON, ROLLING_OFF,
                      STIFFER, DAMPED, RADIUS, MATERIAL, STUFF_WITH_FRICTION, ELLIPSOID,
                      CLUSTER, RADIUS_GONE, SHAPE_GONE, FEED, WALL_GOES, WALL_STOPS, WALL_TURNS,
                      FORCE, GRAVITY_TURNS, FIXED, FREED, CHANGES } change;
/* What the report says before and after. */
static const struct { const char *before, *after; } told[CHANGES] = {
    {"tangential: none", "tangential: spring"},                 /* FRICTION_ON */
    {"tangential: spring", "tangential: none"},
    {"tangential: spring", "tangential: spring"},
    {"rolling: none", "rolling: EPSD"},                         /* ROLLING_ON */
    {"rolling: EPSD", "rolling: none"},
    {" 1 - 1 ", " 1 - 1 "}, {" 1 - 1 ", " 1 - 1 "},             /* STIFFER, DAMPED */
    {"bodies all alike", "bodies of few species"},              /* RADIUS */
    {"bodies all alike", "bodies of few species"},
    {"tangential: none", "tangential: spring"},                 /* STUFF_WITH_FRICTION */
    {"bodies all alike", "1 bodies are not spheres"},
    {"bodies all alike", "1 bodies are not spheres"},
    {"bodies of few species", "bodies all alike"},              /* RADIUS_GONE */
    {"1 bodies are not spheres", "bodies all alike"},
    {"bodies all alike", "bodies of few species"},              /* FEED */
    {"wall 1", "wall 1"}, {"wall 1", "wall 1"}, {"wall 1", "wall 1"},
    {"force field yes", "force field yes"}, {"force field yes", "force field yes"},
    {"bodies all alike", "bodies of few species"},              /* FIXED: another species */
    {"bodies of few species", "bodies all alike"}};

/* ---- fields that act from a time on ---- */

typedef struct field { change what; double since, clock; } field;  /* clock: s to add to the time */
static dem_vec3 push(dem_vec3 x, dem_vec3 v, dem_real r, dem_real m, double time, void *user) {
    const field *f = (const field *)user;
    const double t = time + f->clock, weight = 9.81*(double)m;
    (void)x; (void)v; (void)r;
    if (f->what == FORCE) return t > f->since ? at(50*weight, 0, -30*weight) : at(0, 0, 0);
    /* gravity that turns once in 100 steps */
    return at(50*weight*sin(2*pi*t/(100*tick)), 0, -50*weight*cos(2*pi*t/(100*tick)));
}

/* ---- one scene, before and after ---- */

typedef struct scene {
    dem_world *world;
    dem_material stuff, other;                  /* other: when the scene has it */
    dem_shape egg, pair;
    dem_wall floor;
    dem_body odd;                               /* the one that is not like the others */
    field push;
} scene;
static int side = 13;                           /* grains along each side of the block */

static dem_world_desc scene_desc(change what, scene *s, int threads) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.threads = threads;
    desc.gravity = at(0, 0, what == GRAVITY_TURNS ? 0 : -9.81);
    desc.dt = (dem_real)tick;
    s->push.what = what;
    s->push.since = (BEFORE - 0.5)*tick;
    s->push.clock = 0;
    if (what == FORCE || what == GRAVITY_TURNS) { desc.force = push; desc.force_user = &s->push; }
    if (what == STIFFER || what == DAMPED || what == FIXED || what == FREED)
        desc.normal_law = DEM_NORMAL_LINEAR;
    /* of these the memory would tell what was before */
    if (what != FRICTION_ON && what != FRICTION_OFF && what != FRICTION_AGAIN &&
        what != STUFF_WITH_FRICTION) desc.tangent_law = DEM_TANGENT_VISCOUS;
    return desc;
}
/* Changes that come by themselves, without a call: forces are not looked at once more for them, so
   that only where no force hangs on velocities a new world begins with the same. */
static int by_itself(change what) {
    return what == FEED || what == FORCE || what == GRAVITY_TURNS;
}
/* What holds between grains, and between grains and walls, with the effect or without. */
static void scene_pair(scene *s, change what, int on) {
    dem_pair p;
    const int friction = what == FRICTION_ON || what == FRICTION_AGAIN ? on
        : what == FRICTION_OFF ? !on : what != STUFF_WITH_FRICTION && !by_itself(what);
    const int rolling = what == ROLLING_ON ? on : what == ROLLING_OFF ? !on : 0;
    CHECK_EQ(dem_pair_get(s->world, s->stuff, s->stuff, &p), DEM_OK);
    p.friction = p.friction_static = friction ? DEM_R(0.4) : 0;
    p.rolling_friction = rolling ? DEM_R(0.2) : 0;
    if (what == STIFFER && on) p.young_eff *= 3;
    if (what == DAMPED && on) { p.restitution = DEM_R(0.2); p.tangent_damping = DEM_R(2); }
    CHECK_EQ(dem_pair_set(s->world, s->stuff, s->stuff, &p), DEM_OK);
}
static void scene_other(scene *s, change what) {
    if (what == MATERIAL) s->other = scene_material(s->world, 2e7, 0.5, 0.3, 0);
    if (what == STUFF_WITH_FRICTION) s->other = scene_material(s->world, 1e7, 0.5, 0.6, 0);
}
/* A motion of the floor: sliding up a little, or turning about an axis askew. */
static dem_motion scene_motion(change what, int second) {
    dem_motion m = DEM_MOTION;
    if (what == WALL_GOES || (what == WALL_STOPS && !second)) {
        m.kind = DEM_MOTION_TRANSLATING;
        m.velocity = at(0.5, 0.2, 0.05);
    }
    if (what == WALL_TURNS) {
        m.kind = DEM_MOTION_ROTATING;
        m.axis = second ? at(0.2, 1, 0.3) : at(0, 0, 1);
        m.point = at(0.01, 0.01, 0);
        m.speed = DEM_R(20);
    }
    return m;
}
/* The scene as it is before the change. */
static void scene_begin(scene *s, change what, int threads) {
    static const dem_real balls[6] = {DEM_R(-5e-4), 0, 0, DEM_R(5e-4), 0, 0};
    dem_world_desc desc;
    dem_cluster_desc two = DEM_CLUSTER_DESC;
    memset(s, 0, sizeof *s);
    desc = scene_desc(what, s, threads);
    s->world = dem_world_create(&desc);
    s->stuff = scene_material(s->world, 1e7, by_itself(what) ? 1 : 0.7, 0, 0);
    scene_pair(s, what, 0);
    s->egg = dem_shape_ellipsoid_add(s->world, at(1.2e-3, 8e-4, 1e-3));
    two.count = 2;
    two.positions = balls;
    two.radius = DEM_R(7e-4);
    s->pair = dem_shape_cluster_add(s->world, &two);
}
static void scene_fill(scene *s, change what) {
    const dem_vec3 top = at(0.0128, 0.0128, (side*1.97 + 0.9)*ball_size);
    const dem_quat askew = dem_quat_about(at(1, 2, 3), 1);
    dem_motion m = scene_motion(what, 0);
    int i;
    s->floor = dem_wall_plane_add(s->world, s->stuff, at(0, 0, 0.03*ball_size), at(0, 0, 1));
    if (m.kind) CHECK_EQ(dem_wall_motion_set(s->world, s->floor, &m), DEM_OK);
    scene_block(s->world, s->stuff, side, side, side, ball_size, 0, 0.3, 7);
    for (i = 0; i < dem_bodies_get(s->world).count; i++) {       /* they spin, too */
        const dem_body id = dem_body_id_get(s->world, i);
        const dem_body_state b = scene_state(s->world, id);
        scene_move(s->world, id, b.velocity, at(200*(i%3 - 1), 150*(i%5 - 2), 100));
    }
    if (what == RADIUS_GONE)
        s->odd = dem_sphere_add(s->world, s->stuff, DEM_R(1.3e-3), top);
    if (what == SHAPE_GONE) s->odd = dem_body_add(s->world, s->stuff, s->egg, top, askew);
    if (what == FIXED || what == FREED) s->odd = dem_body_id_get(s->world, side*side*side/2);
    if (what == FREED) {
        dem_body_state b = scene_state(s->world, s->odd);
        b.fixed = 1;
        CHECK_EQ(dem_body_set(s->world, s->odd, &b), DEM_OK);
    }
    if (what == FEED) {
        dem_feed_desc f;
        memset(&f, 0, sizeof f);
        f.material = s->stuff;
        f.class_count = f.limited = 1;
        f.radius[0] = DEM_R(1.3e-3);
        f.amount[0] = 1;
        f.start = (BEFORE - 1.5)*tick;
        /* right above the block, so that it touches within the steps that follow */
        f.box = box_of(0.011, 0.011, (side*1.97 + 1.6)*ball_size, 0.015, 0.015,
                       (side*1.97 + 1.65)*ball_size);
        f.velocity = at(0, 0, -50);
        f.seed = 5;
        CHECK(dem_feed_add(s->world, &f).id);
    }
}
/* The change itself. */
static void scene_change(scene *s, change what) {
    const dem_vec3 top = at(0.0128, 0.0128, (side*1.97 + 0.9)*ball_size);
    const dem_vec3 low = at(0.0128, 0.0128, (side*1.97 + 0.5)*ball_size);
    const dem_quat askew = dem_quat_about(at(1, 2, 3), 1);
    dem_body_state b;
    if (what <= DAMPED) scene_pair(s, what, 1);
    scene_other(s, what);
    if (what == RADIUS) s->odd = dem_sphere_add(s->world, s->stuff, DEM_R(1.3e-3), top);
    if (what == MATERIAL) s->odd = dem_sphere_add(s->world, s->other, (dem_real)ball_size, top);
    if (what == STUFF_WITH_FRICTION) {          /* two, that rub on each other */
        const dem_vec3 on = at(0.0128, 0.0128, (side*1.97 + 2.8)*ball_size);
        s->odd = dem_sphere_add(s->world, s->other, (dem_real)ball_size, top);
        s->odd = dem_sphere_add(s->world, s->other, (dem_real)ball_size, on);
        scene_move(s->world, s->odd, at(0.3, 0, 0), at(0, 300, 0));
    }
    if (what == ELLIPSOID) s->odd = dem_body_add(s->world, s->stuff, s->egg, top, askew);
    if (what == CLUSTER) s->odd = dem_body_add(s->world, s->stuff, s->pair, low, askew);
    if (what == RADIUS_GONE || what == SHAPE_GONE)
        CHECK_EQ(dem_body_remove(s->world, s->odd), DEM_OK);
    if (what == WALL_GOES || what == WALL_STOPS || what == WALL_TURNS) {
        const dem_motion m = scene_motion(what, 1);
        CHECK_EQ(dem_wall_motion_set(s->world, s->floor, &m), DEM_OK);
    }
    if (what == FIXED || what == FREED) {
        b = scene_state(s->world, s->odd);
        b.fixed = what == FIXED;
        CHECK_EQ(dem_body_set(s->world, s->odd, &b), DEM_OK);
    }
}
/* Ids in the order of slots; answers how many. */
static int scene_ids(const dem_world *world, dem_body *ids, int room) {
    const dem_bodies b = dem_bodies_get(world);
    int i, n = 0;
    memset(ids, 0, (size_t)room*sizeof *ids);
    for (i = 0; i < b.count; i++)
        if ((int)b.slots[i] < room) ids[b.slots[i]] = dem_body_id_get(world, i);
    for (i = 0; i < room; i++) if (ids[i].slot) ids[n++] = ids[i];
    return n;
}
/* A world that has what the change brings from its start, and the state that the other is in. */
static void scene_from(scene *s, change what, const scene *other, const dem_body *ids, int count) {
    dem_pose pose;
    dem_motion m = scene_motion(what, 1);
    int i;
    scene_begin(s, what, 1);
    if (what <= DAMPED) scene_pair(s, what, 1);
    scene_other(s, what);
    s->push.since = -1;
    s->push.clock = dem_world_time_get(other->world);
    CHECK_EQ(dem_wall_pose_get(other->world, other->floor, &pose), DEM_OK);
    s->floor = dem_wall_plane_add(s->world, s->stuff, pose.position,
                             dem_vec3_make(pose.rotation[2], pose.rotation[5], pose.rotation[8]));
    if (m.kind) CHECK_EQ(dem_wall_motion_set(s->world, s->floor, &m), DEM_OK);
    for (i = 0; i < count; i++) {
        const dem_body_state b = scene_state(other->world, ids[i]);
        const dem_body id = b.shape.id
            ? dem_body_add(s->world, b.material, b.shape, b.position, b.orientation)
            : dem_sphere_add(s->world, b.material, b.radius, b.position);
        CHECK_EQ(dem_body_set(s->world, id, &b), DEM_OK);
    }
}
typedef struct apart { double place, speed, spin, force; } apart;
static double largest(dem_vec3 a, dem_vec3 b) {
    return fmax(fmax(fabs((double)(a.x - b.x)), fabs((double)(a.y - b.y))),
                fabs((double)(a.z - b.z)));
}
/* Largest differences of two worlds, over the radius, and over the largest of all bodies. */
static apart scene_apart(const scene *a, const dem_body *ia, const scene *b, const dem_body *ib,
                         int count) {
    const dem_vec3 zero = at(0, 0, 0);
    apart d = {0, 0, 0, 0}, most = {0, 1e-9, 1e-9, 1e-9};
    int i;
    for (i = 0; i < count; i++) {
        const dem_body_state s = scene_state(a->world, ia[i]), t = scene_state(b->world, ib[i]);
        d.place = fmax(d.place, largest(s.position, t.position)/ball_size);
        d.speed = fmax(d.speed, largest(s.velocity, t.velocity));
        d.spin = fmax(d.spin, largest(s.spin, t.spin));
        d.force = fmax(d.force, largest(s.force, t.force));
        most.speed = fmax(most.speed, largest(s.velocity, zero));
        most.spin = fmax(most.spin, largest(s.spin, zero));
        most.force = fmax(most.force, largest(s.force, zero));
    }
    d.speed /= most.speed;
    d.spin /= most.spin;
    d.force /= most.force;
    return d;
}
/* Goes up to the change. */
static void scene_up_to(scene *s, change what, int threads) {
    scene_begin(s, what, threads);
    scene_fill(s, what);
    if (what == FRICTION_AGAIN) {               /* on, off, and now on again */
        scene_pair(s, what, 1);
        CHECK_EQ(scene_step(s->world, BEFORE/2), DEM_OK);
        scene_report_has(s->world, told[what].before);
        scene_pair(s, what, 0);
        CHECK_EQ(scene_step(s->world, BEFORE/2), DEM_OK);
        scene_report_has(s->world, "tangential: none");
        return;
    }
    CHECK_EQ(scene_step(s->world, BEFORE/2), DEM_OK);
    scene_report_has(s->world, told[what].before);
    CHECK_EQ(scene_step(s->world, BEFORE - BEFORE/2), DEM_OK);
}
/* The run with two threads, and with a checkpoint between the change and the next step. */
static void scene_again(change what, uint64_t hash) {
    scene s;
    scene_up_to(&s, what, 2);
    scene_change(&s, what);
    CHECK_EQ(dem_checkpoint_write(s.world, saved), DEM_OK);
    CHECK_EQ(scene_step(s.world, AFTER), DEM_OK);
    if (side == 13) CHECK(dem_counters_get(s.world).domains >= 2);
    CHECK_EQ(dem_world_hash_get(s.world), hash);
    CHECK_EQ(dem_checkpoint_read(s.world, saved), DEM_OK);
    CHECK_EQ(scene_step(s.world, AFTER), DEM_OK);
    CHECK_EQ(dem_world_hash_get(s.world), hash);
    dem_world_destroy(s.world);
}
/* Along x nothing but the field pushes: smooth grains, a smooth floor. What it gives is the sum
   over steps of the mean of its values at both ends. */
static void push_given(const scene *s, double before) {
    const dem_totals t = dem_totals_get(s->world);
    double sum = 0;
    int k;
    for (k = 0; k < AFTER; k++) {
        const double begin = (BEFORE + k)*tick, end = begin + tick;
        const dem_vec3 none = at(0, 0, 0);
        sum += (double)(push(none, none, 0, 1, begin, (void *)(uintptr_t)&s->push).x +
                        push(none, none, 0, 1, end, (void *)(uintptr_t)&s->push).x)*tick/2;
    }
    /* sums of 2197 numbers of momentum, all of up to 0.3 m/s */
    CHECK_NEAR(t.momentum[0] - before, t.mass*sum, t.mass*0.3*(DEMI_SINGLE ? 1e-6 : 1e-13));
    CHECK(sum > 1e-4);                          /* m/s */
}
/* sums of some six forces in another order: an overlap of .03 R is a difference of numbers of 20
   R, so that a unit of round-off becomes 667 */
static double small(void) { return 667*(DEMI_SINGLE ? 1.2e-7 : 2.2e-16); }
enum { ROOM = 2300 };
static dem_body ids[3][ROOM];

/* Without the change the run is another one: of what is compared something would be seen. */
static void change_matters(const scene *a, change what, uint64_t hash) {
    const int count = side*side*side;
    scene c;
    apart d;
    scene_up_to(&c, what, 1);
    CHECK_EQ(scene_step(c.world, AFTER), DEM_OK);
    CHECK(dem_world_hash_get(c.world) != hash);
    scene_ids(c.world, ids[2], ROOM);
    d = scene_apart(a, ids[0], &c, ids[2], count);
    CHECK(d.speed + d.spin > 50*small());
    dem_world_destroy(c.world);
}
static void changed(change what) {
    scene a, b;
    uint64_t hash;
    double before;
    int count, k;
    scene_up_to(&a, what, 1);
    scene_change(&a, what);
    count = scene_ids(a.world, ids[0], ROOM);
    scene_from(&b, what, &a, ids[0], count);
    CHECK_EQ(scene_ids(b.world, ids[1], ROOM), count);
    before = dem_totals_get(a.world).momentum[0];
    for (k = 0; k < 2; k++) {                   /* the forces right after the change, and later */
        apart d;
        CHECK_EQ(scene_step(a.world, k ? AFTER - 1 : 1), DEM_OK);
        CHECK_EQ(scene_step(b.world, k ? AFTER - 1 : 1), DEM_OK);
        scene_report_has(a.world, told[what].after);
        scene_report_has(b.world, told[what].after);
        d = scene_apart(&a, ids[0], &b, ids[1], count);
        CHECK_NEAR(d.place, 0, small());
        CHECK_NEAR(d.speed, 0, small());
        CHECK_NEAR(d.spin, 0, small());
        CHECK_NEAR(d.force, 0, small());
    }
    hash = dem_world_hash_get(a.world);
    if (what == FORCE || what == GRAVITY_TURNS) push_given(&a, before);
    scene_again(what, hash);
    if (!by_itself(what)) change_matters(&a, what, hash);
    if (what == FEED) {                         /* it is there, and touches */
        CHECK_EQ(count, side*side*side + 1);
        CHECK((double)scene_state(a.world, ids[0][count - 1]).force.z > 0);
    }
    dem_world_destroy(a.world);
    dem_world_destroy(b.world);
}

/* ---- every law, every integrator ---- */

/* 64 grains; friction, or rolling friction, comes in mid-run, under these laws. */
static void law_comes(dem_normal_law normal, dem_tangent_law tangent, dem_rolling_law rolling,
                      dem_integrator integrator) {
    static const char *const names[] = {"auto", "none", "viscous", "step", "spring", "Mindlin",
                                        "Mindlin, rescaled"};
    static const char *const rolls[] = {"auto", "none", "step", "constant torque", "EPSD"};
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_pair p;
    scene s[2];
    apart d;
    char words[60];
    int w, i;
    memset(s, 0, sizeof s);
    desc.threads = 1;
    desc.gravity = at(0, 0, -9.81);
    desc.dt = (dem_real)tick;
    desc.normal_law = normal;
    desc.tangent_law = tangent;
    desc.rolling_law = rolling;
    desc.integrator = integrator;
    for (w = 0; w < 2; w++) {
        dem_material_desc m = scene_stuff(1e7, 0.7, rolling == DEM_ROLLING_NONE ? 0 : 0.4, 0);
        s[w].world = dem_world_create(&desc);
        s[w].stuff = dem_material_add(s[w].world, &m);
        dem_wall_plane_add(s[w].world, s[w].stuff, at(0, 0, 0.03*ball_size), at(0, 0, 1));
        if (!w) {
            scene_block(s[w].world, s[w].stuff, 4, 4, 4, ball_size, 0, 0.3, 7);
            for (i = 0; i < 64; i++) {
                const dem_body id = dem_body_id_get(s[w].world, i);
                scene_move(s[w].world, id, scene_state(s[w].world, id).velocity,
                           at(200*(i%3 - 1), 150*(i%5 - 2), 100));
            }
            CHECK_EQ(scene_step(s[w].world, BEFORE), DEM_OK);
        }
        dem_pair_get(s[w].world, s[w].stuff, s[w].stuff, &p);
        p.friction = p.friction_static = DEM_R(0.4);
        p.rolling_friction = rolling == DEM_ROLLING_NONE ? 0 : DEM_R(0.2);
        CHECK_EQ(dem_pair_set(s[w].world, s[w].stuff, s[w].stuff, &p), DEM_OK);
        if (w) {
            for (i = 0; i < 64; i++) {
                const dem_body_state b = scene_state(s[0].world, ids[0][i]);
                const dem_body id = dem_sphere_add(s[w].world, s[w].stuff, b.radius, b.position);
                CHECK_EQ(dem_body_set(s[w].world, id, &b), DEM_OK);
            }
        }
        CHECK_EQ(scene_ids(s[w].world, ids[w], ROOM), 64);
    }
    for (w = 0; w < 2; w++) {
        CHECK_EQ(scene_step(s[w].world, AFTER), DEM_OK);
        snprintf(words, sizeof words, "tangential: %s", names[tangent]);
        scene_report_has(s[w].world, words);
        snprintf(words, sizeof words, "rolling: %s", rolls[rolling]);
        scene_report_has(s[w].world, words);
    }
    d = scene_apart(&s[0], ids[0], &s[1], ids[1], 64);
    CHECK_NEAR(d.place, 0, small());
    CHECK_NEAR(d.speed, 0, small());
    CHECK_NEAR(d.spin, 0, small());
    CHECK_NEAR(d.force, 0, small());
    for (w = 0; w < 2; w++) dem_world_destroy(s[w].world);
}

/* ---- adhesion ---- */

/* N, of the hysteretic law whose depth was D: [ALK07] eq 2.41 to 2.49 */
static double sticky(double d, double *D, double kn, double kun, double kad) {
    const double most = d*(kun + kad)/(kun - kn);
    *D = fmax(*D, d);
    if (most < *D) *D = most;
    return kun*d - (kun - kn)*(*D);
}

/* ---- functions of the user's that try to change the world ---- */

enum { FROM_EACH, FROM_BONDS, FROM_MOTION, FROM_FORCE, FROM_LAW, FROM_REALS, FROM_PROGRESS, FROM_NUMBER, FROM_FEED,
       FROM_FILL, FROM_PACK, FROM_VALUES, FROM_ALLOCATOR, FROM_ADVISE, FROM_REPORT, FROM_CONTACTS, FROM_SLABS, FROM_COUNT };
static const char *const intruders[FROM_COUNT] = {
    "contact function", "bond function", "motion", "force", "law", "rate of numbers", "progress function", "replay's number",
    "feed's region", "filled region", "packed region", "output's values", "allocator", "law of a trial",
    "force in a report", "law in a look", "law in slabs"};
/* One to change the world: 1 when it was refused by name and for that reason. The calls of a law are
   made by two threads at a time. */
typedef struct intruder {
    dem_world *world;
    dem_material stuff;
    dem_wall wall;
    dem_slabs *slabs;
    dem_replay *film;
    const char *file;
    long calls, refused;
} intruder;
static intruder intrudes;
static void intrude_each(const dem_contact_info *c, dem_real *m, void *u);
static int intrude_one(int k) {
    dem_world *w = intrudes.world;
    const dem_body first = dem_body_id_get(w, 0);
    dem_motion still = DEM_MOTION;
    dem_output_desc output = DEM_OUTPUT_DESC;
    const dem_vec3 v = at(1, 2, 3);
    switch (k) {
    case 0: return dem_body_remove(w, first) != DEM_OK;
    case 1: return !dem_sphere_add(w, intrudes.stuff, DEM_R(1e-3), v).slot;
    case 2: return dem_candidates_rebuild(w) != DEM_OK;
    case 3: return dem_world_step(w, 1) != DEM_OK;
    case 4: return !dem_wall_plane_add(w, intrudes.stuff, v, v).id;
    case 5: return dem_wall_remove(w, intrudes.wall) != DEM_OK;
    case 6: return dem_checkpoint_read(w, intrudes.file) != DEM_OK;
    case 7: return dem_world_gravity_set(w, v) != DEM_OK;
    case 8: return dem_world_run(w, 1e-3, 0, 0) != DEM_OK;
    case 9: return dem_wall_motion_set(w, intrudes.wall, &still) != DEM_OK;
    case 10: dem_world_destroy(w); return 1;
    case 11: output.interval = 1; output.kind = DEM_OUTPUT_VTP; output.path = "no.vtp";
        return !dem_output_add(w, &output).id;
    case 12: return dem_world_check(w, 0, 0) == 0;
    case 13: return dem_contacts_each(w, intrude_each, 0) < 0;
    case 14: return dem_world_dt_set(w, DEM_R(1e-9)) != DEM_OK;
    default: return -1;
    }
}
/* The first calls alone: each tries them all. */
static void intrude(void) {
    int k, answer;
    if ((!intrudes.world && !intrudes.slabs) || intrudes.calls > 3) return;
#ifdef _OPENMP
    #pragma omp atomic
#endif
    intrudes.calls++;
    if (intrudes.slabs) {                       /* a world that was dealt to slabs may be changed */
        dem_slabs_destroy(intrudes.slabs);
        if (dem_slabs_step(intrudes.slabs, 1) == DEM_OK) intrudes.refused--;
        return;
    }
    for (k = 0; (answer = intrude_one(k)) >= 0; k++)
        if (!answer) {
#ifdef _OPENMP
            #pragma omp atomic
#endif
            intrudes.refused--;
        }
}
static void intrude_each(const dem_contact_info *c, dem_real *m, void *u) { (void)c; (void)m; (void)u; intrude(); }
static void intrude_motion(double t, dem_pose *p, void *u) {
    (void)t; (void)u;
    memset(p, 0, sizeof *p);
    p->rotation[0] = p->rotation[4] = p->rotation[8] = 1;
    intrude();
}
static dem_vec3 intrude_force(dem_vec3 x, dem_vec3 v, dem_real r, dem_real m, double t, void *u) {
    (void)x; (void)v; (void)r; (void)m; (void)t; (void)u;
    intrude();
    return at(0, 0, 0);
}
static void intrude_law(const dem_contact *c, dem_real *m, dem_contact_force *f) {
    (void)m;
    f->normal = 1000*c->overlap;
    intrude();
}
static void intrude_reals(dem_real *reals, const dem_real *rates, const dem_body_state *body, dem_body id, double time, dem_real dt,
                          void *user) {
    (void)reals; (void)rates; (void)body; (void)id; (void)time; (void)dt; (void)user;
    intrude();
}
static int intrude_progress(const dem_world *w, double a, double b, void *u) { (void)w; (void)a; (void)b; (void)u; intrude(); return 0; }
static double intrude_number(const dem_world *w, dem_body b, void *u) { (void)w; (void)b; (void)u; intrude(); return 0; }
static int intrude_region(dem_vec3 x, dem_real r, void *u) { (void)x; (void)r; (void)u; intrude(); return 1; }
static void intrude_values(const dem_world *w, double *v, void *u) { (void)w; (void)u; v[0] = 0; intrude(); }
static void *intrude_alloc(size_t size, void *u) { if (*(int *)u) intrude(); return malloc(size); }
static void intrude_free(void *memory, size_t size, void *u) { (void)size; if (*(int *)u) intrude(); free(memory); }
/* A bed on a floor; from `begin` on the function that `from` names tries to change it. The hash after
   steps that follow. */
static uint64_t intruded(int from, int begin, int response) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_motion motion = DEM_MOTION;
    dem_output_desc output = DEM_OUTPUT_DESC;
    dem_replay_desc film = DEM_REPLAY_DESC;
    dem_feed_desc feed = DEM_FEED_DESC;
    dem_region region = DEM_REGION;
    dem_slabs_desc slabs = DEM_SLABS_DESC;
    const dem_box above = box_of(0, 0, 0.02, 0.02, 0.02, 0.03);
    dem_real x[3*27];
    dem_world *w;
    int i, trying = 0;
    uint64_t hash;
    intrudes.world = 0;
    intrudes.calls = intrudes.refused = 0;
    desc.gravity.z = DEM_R(-9.81);
    desc.threads = 2;
    desc.dt = DEM_R(1e-6);
    if (response) desc.response = DEM_RESPONSE_IMPULSES;
    if (from == FROM_FORCE || from == FROM_REPORT) desc.force = intrude_force;
    if (from == FROM_LAW || from == FROM_ADVISE || from == FROM_CONTACTS || from == FROM_SLABS) { desc.law = intrude_law; desc.law_stiffness = 1000; }
    if (from == FROM_REALS) { desc.body_reals = "t"; desc.body_reals_fn = intrude_reals; }
    if (from == FROM_ALLOCATOR) { desc.allocator.alloc_fn = intrude_alloc; desc.allocator.free_fn = intrude_free; desc.allocator.user = &trying; }
    w = dem_world_create(&desc);
    intrudes.stuff = scene_material(w, 1e6, 0.5, 0.5, 0);
    intrudes.wall = dem_wall_plane_add(w, intrudes.stuff, at(0, 0, 0), at(0, 0, 1));
    for (i = 0; i < 27; i++) {
        x[3*i] = DEM_R(1.99e-3)*(dem_real)(i%3);
        x[3*i + 1] = DEM_R(1.99e-3)*(dem_real)(i/3%3);
        x[3*i + 2] = DEM_R(0.995e-3) + DEM_R(1.99e-3)*(dem_real)(i/9);
    }
    dem_spheres_add(w, intrudes.stuff, 27, x, 0, 0, DEM_R(1e-3));
    dem_world_step(w, 3);
    intrudes.file = saved;
    CHECK_EQ(dem_checkpoint_write(w, saved), DEM_OK);
    if (begin) intrudes.world = w;
    trying = begin;
    motion.kind = DEM_MOTION_USER; motion.function = intrude_motion;
    film.number_fn = intrude_number;
    feed.material = intrudes.stuff; feed.class_count = 1; feed.radius[0] = DEM_R(1e-3); feed.amount[0] = 1; feed.rate = 1e6;
    feed.box = region.box = above; feed.inside = region.inside = intrude_region;
    output.kind = DEM_OUTPUT_CSV; output.path = "build/tmp/intruded.csv"; output.columns = "a"; output.values = intrude_values;
    output.interval = 1e-6;
    slabs.count = 2;
    switch (from) {
    case FROM_EACH: dem_contacts_each(w, intrude_each, 0); break;
    case FROM_BONDS: dem_bonds_make(w, 0, intrude_each, 0); break;
    case FROM_MOTION: dem_wall_motion_set(w, intrudes.wall, &motion); break;
    case FROM_PROGRESS: dem_world_run(w, 1e-5, intrude_progress, 0); break;
    case FROM_NUMBER: { dem_replay *r = dem_replay_open(w, "build/tmp/intruded.html", &film); dem_replay_frame_write(r); dem_replay_close(r); break; }
    case FROM_FEED: dem_feed_add(w, &feed); break;
    case FROM_FILL: dem_spheres_fill(w, intrudes.stuff, DEM_R(1e-3), region, 20, 1); break;
    case FROM_PACK: dem_spheres_pack(w, intrudes.stuff, DEM_R(1e-3), 0,
                                     dem_region_inside_make(above, intrude_region, 0), 20); break;
    case FROM_VALUES: dem_output_add(w, &output); break;
    case FROM_ALLOCATOR: dem_spheres_fill(w, intrudes.stuff, DEM_R(1e-3), dem_region_make(above), 200, 1); break;
    case FROM_ADVISE: {
        dem_effect effects[DEM_EFFECTS];
        CHECK_EQ(dem_effects_get(w, 0.02, effects), DEM_EFFECTS);
        break;
    }
    case FROM_REPORT: { FILE *out = tmpfile(); dem_world_report(w, out); fclose(out); break; }
    case FROM_CONTACTS: { static dem_contact_info found[100]; CHECK(dem_contacts_get(w, found, 100) > 0); break; }
    case FROM_SLABS: {
        dem_slabs *dealt = dem_slabs_create(w, &slabs);
        intrudes.world = 0;
        if (begin) intrudes.slabs = dealt;
        CHECK_EQ(dem_slabs_step(dealt, 3), DEM_OK);
        intrudes.slabs = 0;
        if (begin) CHECK_STR(dem_slabs_error_get(dealt), "dem_slabs_step: called from a function that");
        if (begin) CHECK(intrudes.calls > 0 && intrudes.refused == 0);
        CHECK_EQ(dem_slabs_collect(dealt, w), DEM_OK);
        dem_slabs_destroy(dealt);
        break;
    }
    default: break;
    }
    dem_world_step(w, 3);                       /* stops short where a refusal builds the scene */
    if (from == FROM_REPORT || from == FROM_CONTACTS) intrudes.world = 0;
    if (begin && from != FROM_SLABS) {
        CHECK(intrudes.calls > 0 && intrudes.refused == 0);
        CHECK_STR(dem_world_error_get(w), "called from a function that");
        if (intrudes.refused) printf("        from a %s: %ld calls were not refused\n", intruders[from], -intrudes.refused);
    }
    trying = 0;
    intrudes.world = 0;
    dem_world_error_get(w);
    dem_world_step(w, 20 - (int)dem_world_steps_get(w));
    if (from == FROM_PROGRESS) dem_world_step(w, 10);
    hash = dem_world_hash_get(w);
    dem_world_destroy(w);
    remove("build/tmp/intruded.csv");
    remove("build/tmp/intruded.html");
    remove(saved);
    return hash;
}

/* A ball pressed into a floor, which it slides along. */
static dem_world *slid_world(int orientations, dem_material *m, dem_body *ball, const dem_body_state *as) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    desc.threads = 1;
    desc.dt = DEM_R(1e-6);
    desc.orientations = orientations;
    desc.response = orientations ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS;
    world = dem_world_create(&desc);
    *m = scene_material(world, 1e6, 1, 0.5, 0);
    *ball = dem_sphere_add(world, *m, DEM_R(0.01), at(0, 0, 0.00999));
    scene_move(world, *ball, at(1e-3, 0, 0), at(0, 0, 0));
    if (as) CHECK_EQ(dem_body_set(world, *ball, as), DEM_OK);
    return world;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("ids of removed walls name nothing, though 200,000 walls that come and go leave few places") {
        dem_material m;
        dem_body ball;
        dem_world *world = slid_world(0, &m, &ball, 0);
        const dem_wall first = dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        dem_wall last = first;
        dem_pose pose;
        int i, wrong = 0;
        for (i = 0; i < 200000; i++) {
            wrong += dem_wall_remove(world, last) != DEM_OK;
            last = dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
            wrong += last.id <= 0 || last.id == first.id;
        }
        CHECK_EQ(wrong, 0);
        CHECK(world->wall_count < 40);
        CHECK_EQ(dem_wall_pose_get(world, first, &pose), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "does not exist any more");
        CHECK_EQ(dem_wall_pose_get(world, last, &pose), DEM_OK);
        dem_world_destroy(world);
    }
    TEST("a wall in the place of a removed one has no contact history of it, and a joint to the removed wall has ended") {
        dem_material m, n;
        dem_body ball, fresh_ball;
        dem_world *world = slid_world(0, &m, &ball, 0), *fresh;
        const dem_wall floor_ = dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        dem_wall again;
        dem_body_state state;
        dem_contact_info contact;
        dem_joint_desc hinge = DEM_JOINT_DESC;
        dem_joint_state held;
        dem_joint joint;
        double loaded;
        CHECK_EQ(dem_world_step(world, 50), DEM_OK);
        state = scene_state(world, ball);
        loaded = (double)state.force.x;
        CHECK_EQ(dem_wall_remove(world, floor_), DEM_OK);
        again = dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        CHECK(again.id != floor_.id && world->wall_count == 1);
        fresh = slid_world(0, &n, &fresh_ball, &state);
        dem_wall_plane_add(fresh, n, at(0, 0, 0), at(0, 0, 1));
        CHECK_EQ(dem_world_step(world, 1), DEM_OK);
        CHECK_EQ(dem_world_step(fresh, 1), DEM_OK);
        CHECK_NEAR((double)scene_state(world, ball).force.x, (double)scene_state(fresh, fresh_ball).force.x, 1e-9*fabs(loaded));
        CHECK_NEAR((double)scene_state(world, ball).force.x/loaded, 0, 0.5);
        CHECK_EQ(dem_contacts_get(world, &contact, 1), 1);
        CHECK_EQ(contact.wall, again.id);
        dem_world_destroy(fresh);
        dem_world_destroy(world);
        world = slid_world(1, &m, &ball, 0);
        again = dem_wall_plane_add(world, m, at(0, 0, -1), at(0, 0, 1));
        hinge.kind = DEM_JOINT_POINT;
        hinge.a = ball;
        hinge.wall = again;
        joint = dem_joint_add(world, &hinge);
        CHECK_EQ(dem_world_step(world, 2), DEM_OK);
        CHECK_EQ(dem_wall_remove(world, again), DEM_OK);
        dem_wall_plane_add(world, m, at(0, 0, -1), at(0, 0, 1));
        CHECK_EQ(dem_joint_get(world, joint, &held), DEM_ERROR_ARGUMENT);
        CHECK_EQ(dem_world_step(world, 2), DEM_OK);
        dem_world_destroy(world);
    }
    TEST("a replay and a checkpoint distinguish a wall from the removed wall whose place it takes") {
        static const char *const page = "build/tmp/changes_walls.html";
        dem_material m;
        dem_body ball;
        dem_world *world = slid_world(0, &m, &ball, 0), *other;
        dem_replay *replay = dem_replay_open(world, page, 0);
        dem_wall wall = dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        char text[4000];
        size_t size;
        int k, walls = 0;
        FILE *file;
        CHECK_EQ(dem_replay_frame_write(replay), DEM_OK);
        dem_wall_remove(world, wall);
        wall = dem_wall_cylinder_add(world, m, at(0, 0, 0), at(0, 0, 1), 1, 1);
        CHECK_EQ(dem_replay_frame_write(replay), DEM_OK);
        CHECK_EQ(dem_replay_close(replay), DEM_OK);
        file = fopen(page, "rb");
        text[0] = 0;
        for (size = 0; file && fgets(text, sizeof text, file); size++)
            walls += strstr(text, "\"kind\":\"plane\"") || strstr(text, "\"kind\":\"cylinder\"");
        if (file) fclose(file);
        CHECK_EQ(walls, 2);
        CHECK_EQ(dem_world_step(world, 3), DEM_OK);
        CHECK_EQ(dem_checkpoint_write(world, saved), DEM_OK);
        for (k = 0; k < 2; k++) {
            other = slid_world(0, &m, &ball, 0);
            if (!k) dem_wall_remove(other, dem_wall_plane_add(other, m, at(0, 0, 0), at(0, 0, 1)));
            dem_wall_cylinder_add(other, m, at(0, 0, 0), at(0, 0, 1), 1, 1);
            CHECK_EQ(dem_checkpoint_read(other, saved), k ? DEM_ERROR_FORMAT : DEM_OK);
            if (k) CHECK_STR(dem_world_error_get(other), "id");
            else CHECK(dem_world_hash_get(other) == dem_world_hash_get(world));
            dem_world_destroy(other);
        }
        dem_world_destroy(world);
        remove(saved);
        remove(page);
    }
    TEST("ids of walls go on from the later of checkpoint and world, and an id of another place is rejected") {
        int k;
        for (k = 0; k < 2; k++) {
            dem_material m;
            dem_body ball;
            dem_world *world = slid_world(0, &m, &ball, 0), *other;
            dem_wall late;
            dem_wall_remove(world, dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1)));
            if (k) world->walls[0].id = 7;
            CHECK_EQ(dem_checkpoint_write(world, saved), DEM_OK);
            other = slid_world(0, &m, &ball, 0);
            dem_wall_remove(other, dem_wall_plane_add(other, m, at(0, 0, 0), at(0, 0, 1)));
            late = dem_wall_plane_add(other, m, at(0, 0, 0), at(0, 0, 1));
            CHECK_EQ(dem_checkpoint_read(other, saved), k ? DEM_ERROR_FORMAT : DEM_OK);
            if (k) CHECK_STR(dem_world_error_get(other), "place 1 has the id 7");
            else CHECK(dem_wall_plane_add(other, m, at(0, 0, 0), at(0, 0, 1)).id > late.id);
            dem_world_destroy(other);
            dem_world_destroy(world);
        }
        remove(saved);
    }
    TEST("a user function (law, field, motion, region) that changes the world gets an error and changes no bit") {
        int from, response;
        for (response = 0; response < 2; response++)
            for (from = 0; from < FROM_COUNT; from++) {
                if (response && (from == FROM_BONDS || from == FROM_LAW || from == FROM_ADVISE || from == FROM_CONTACTS || from == FROM_SLABS)) continue;
                CHECK(intruded(from, 0, response) == intruded(from, 1, response));
            }
    }
    TEST("friction, rolling friction, stiffness and damping set by dem_pair_set in mid-run act from the next step on") {
        int what;
        for (what = FRICTION_ON; what <= DAMPED; what++) changed((change)what);
    }
    TEST("the first grain of another radius, material, friction or shape among 2197 acts as if present from the "
         "start") {
        int what;
        for (what = RADIUS; what <= CLUSTER; what++) changed((change)what);
    }
    TEST("when the last unlike grain is removed, the rest counts as alike again and runs as if it had never been "
         "there") {
        changed(RADIUS_GONE);
        changed(SHAPE_GONE);
    }
    TEST("a feed's first unlike grain, a force that begins, and rotating gravity act as if present from the start") {
        changed(FEED);
        changed(FORCE);
        changed(GRAVITY_TURNS);
    }
    TEST("a floor that starts to slide, stops or changes its axis acts as one that moved so from the start") {
        changed(WALL_GOES);
        changed(WALL_STOPS);
        changed(WALL_TURNS);
    }
    TEST("a grain fixed or released in mid-run collides as one that was so from the start") {
        changed(FIXED);
        changed(FREED);
    }
    TEST("friction and rolling friction of every law, normal law and integrator act in mid-run as from the start") {
        int n, t, r, i;
        const int last = DEM_INTEGRATOR_LEAPFROG;
        for (n = DEM_NORMAL_HERTZ; n <= DEM_NORMAL_LINEAR; n++) {
            for (t = DEM_TANGENT_VISCOUS; t <= DEM_TANGENT_MINDLIN_RESCALED; t++)
                for (i = DEM_INTEGRATOR_VELOCITY_VERLET; i <= last; i++)
                    law_comes((dem_normal_law)n, (dem_tangent_law)t, DEM_ROLLING_NONE,
                              (dem_integrator)i);
            for (r = DEM_ROLLING_STEP; r <= DEM_ROLLING_EPSD; r++)
                for (i = DEM_INTEGRATOR_VELOCITY_VERLET; i <= last; i++)
                    law_comes((dem_normal_law)n, DEM_TANGENT_VISCOUS, (dem_rolling_law)r,
                              (dem_integrator)i);
        }
    }
    TEST("adhesion that starts, grows and ends during a sticky contact keeps the loaded depth and the law's force") {
        const double kn = 2e3, kun = 8e3, kads[4] = {0, 1e3, 4e3, 0};   /* N/m */
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_material_desc d = scene_stuff(1e7, 0.5, 0, 0);
        dem_world *world;
        dem_material m;
        dem_body ball;
        dem_pair p;
        double deep = 0, last = 0;
        int i, k;
        desc.threads = 1;
        desc.normal_law = DEM_NORMAL_HYSTERETIC;
        desc.dt = DEM_R(1e-9);                  /* nothing moves but where it is put */
        d.stiffness = (dem_real)kn;
        world = dem_world_create(&desc);
        m = dem_material_add(world, &d);
        dem_wall_plane_add(world, m, at(0, 0, -ball_size), at(0, 0, 1));
        ball = dem_sphere_add(world, m, (dem_real)ball_size, at(0, 0, -0.02*ball_size));
        for (i = 0; i < 4; i++) {
            static const double places[4][3] = {{0.02, 0.05, 0.04}, {0.04, 0.038, 0.035},
                                                {0.035, 0.03, 0.02}, {0.02, 0.03, 0.06}};
            dem_pair_get(world, m, m, &p);
            p.stiffness = (dem_real)kn;
            p.restitution = DEM_R(0.5);         /* kun = kn/e^2 */
            p.stiffness_adhesion = (dem_real)kads[i];
            CHECK_EQ(dem_pair_set(world, m, m, &p), DEM_OK);
            for (k = 0; k < 3; k++) {
                dem_body_state s = scene_state(world, ball);
                const double overlap = places[i][k]*ball_size;
                double f;
                s.position = at(0, 0, -overlap);
                s.velocity = at(0, 0, 0);
                CHECK_EQ(dem_body_set(world, ball, &s), DEM_OK);
                CHECK_EQ(scene_step(world, 1), DEM_OK);
                f = sticky(overlap, &deep, kn, kun, kads[i]);
                /* N: kun times the round-off of the overlap, and what the ball moves in 1e-9 s */
                CHECK_NEAR(scene_state(world, ball).force.z, f, kun*ball_size*(DEMI_SINGLE ? 1e-6
                                                                                         : 1e-11));
                if (i == 2 && k) CHECK(f < 0);  /* it pulls there */
                last = f;
            }
        }
        CHECK(last > 0);
        dem_world_destroy(world);
    }
    TEST("a free grain under uniformly rotating gravity moves on the analytic circle, to second order in dt") {
        /* x'' = g sin wt, z'' = -g cos wt from v = (-g/w, 0): x = -g sin wt/w^2, z = g (cos wt - 1)
           /w^2 after any time; 50 g and a turn in 200 us, as push has it */
        double off[2];
        int half;
        for (half = 0; half < 2; half++) {
            const double w = 2*pi/(100*tick), g = 50*9.81, dt = half ? tick/2 : tick;
            dem_world_desc desc = DEM_WORLD_DESC;
            scene s;
            dem_body ball;
            dem_body_state b;
            double t;
            memset(&s, 0, sizeof s);
            s.push.what = GRAVITY_TURNS;
            desc.force = push;
            desc.force_user = &s.push;
            desc.dt = (dem_real)dt;
            desc.threads = 1;
            s.world = dem_world_create(&desc);
            s.stuff = scene_material(s.world, 1e7, 0.5, 0.3, 0);
            ball = dem_sphere_add(s.world, s.stuff, (dem_real)ball_size, at(0, 0, 0));
            scene_move(s.world, ball, at(-g/w, 0, 0), at(0, 0, 0));
            CHECK_EQ(scene_step(s.world, half ? 660 : 330), DEM_OK);
            b = scene_state(s.world, ball);
            t = 330*tick;
            off[half] = hypot((double)b.position.x + g*sin(w*t)/(w*w),
                              (double)b.position.z - g*(cos(w*t) - 1)/(w*w))*w*w/g;
            dem_world_destroy(s.world);
        }
        { /* sums for integrals of sin, cos: off by (w dt)^2/12 of them; in place by w t of that */
            const double w = 2*pi/100;
            CHECK(off[0] < w*w/12*(w*330 + 2));
            CHECK(off[0] > w*w/12*(w*330 - 2));
            CHECK_NEAR(off[0]/off[1], 4, DEMI_SINGLE ? 0.1 : 0.02);
        }
    }
    TEST("gravity set between steps bends a path into two parabolas, and ledger, checkpoint, desc and slabs follow "
         "it") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *w, *other = 0;
        dem_material m;
        dem_body ball;
        dem_body_state b;
        dem_ledger ledger;
        dem_slabs_desc cut = DEM_SLABS_DESC;
        dem_slabs *slabs;
        uint64_t hash = 0;
        int k;
        desc.gravity = at(0, 0, -10);
        desc.dt = DEM_R(1e-5);
        desc.threads = 1;
        w = dem_world_create(&desc);
        m = scene_material(w, 1e6, 0.5, 0.3, 0);
        ball = dem_sphere_add(w, m, DEM_R(1e-3), at(0, 0, 0));
        CHECK_EQ(scene_step(w, 10000), DEM_OK);
        CHECK_EQ(dem_world_gravity_set(w, at(20, 0, 0)), DEM_OK);
        CHECK_EQ(dem_world_gravity_set(w, at(NAN, 0, 0)), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(w), "must be finite");
        CHECK_EQ(scene_step(w, 10000), DEM_OK);
        b = scene_state(w, ball);
        CHECK_NEAR(b.velocity.x, 2, 20000*2*eps());
        CHECK_NEAR(b.velocity.z, -1, 20000*2*eps());
        CHECK_NEAR(b.position.x, 0.1, 20000*eps());
        CHECK_NEAR(b.position.z, -0.05 - 0.1, 20000*eps());
        CHECK_NEAR(dem_world_desc_get(w).gravity.x, 20, 0);
        dem_world_destroy(w);
        for (k = 0; k < 3; k++) {               /* a box that is turned by quarters; saved on the way; in slabs */
            int quarter;
            desc.gravity = at(0, 0, -10);
            desc.dt = DEM_R(2e-5);
            desc.ledger = 1;
            w = dem_world_create(&desc);
            m = scene_material(w, 1e6, 0.5, 0.3, 0);
            for (quarter = 0; quarter < 6; quarter++) {
                const double side = quarter%2 ? -1 : 1, far = quarter%2 ? 0.012 : 0;
                dem_wall_plane_add(w, m, at(quarter/2 == 0 ? far : 0, quarter/2 == 1 ? far : 0, quarter/2 == 2 ? far : 0),
                              at(quarter/2 == 0 ? side : 0, quarter/2 == 1 ? side : 0, quarter/2 == 2 ? side : 0));
            }
            dem_spheres_fill(w, m, DEM_R(1e-3), dem_region_make(box_of(0, 0, 0, 0.012, 0.012, 0.012)), 60, 3);
            for (quarter = 0; quarter < 4; quarter++) {
                const dem_vec3 g[4] = {at(0, 0, -10), at(10, 0, 0), at(0, 0, 10), at(-10, 0, 0)};
                CHECK_EQ(dem_world_gravity_set(w, g[quarter]), DEM_OK);
                CHECK_EQ(scene_step(w, 1000), DEM_OK);
                if (k == 1 && quarter == 2) {   /* goes on in another world */
                    CHECK_EQ(dem_checkpoint_write(w, "build/tmp/gravity.dem"), DEM_OK);
                    CHECK_EQ(dem_world_gravity_set(w, at(0, 0, -10)), DEM_OK);
                    CHECK_EQ(dem_checkpoint_read(w, "build/tmp/gravity.dem"), DEM_OK);
                    CHECK_NEAR(dem_world_desc_get(w).gravity.z, 10, 0);
                }
            }
            CHECK_EQ(scene_step(w, 1000), DEM_OK);
            ledger = dem_ledger_get(w);
            CHECK(fabs(ledger.residual) < 2e-3*ledger.throughput);
            if (!k) hash = dem_world_hash_get(w);
            else CHECK(dem_world_hash_get(w) == hash);
            if (k == 2) {
                cut.count = 2;
                other = w;
                slabs = dem_slabs_create(other, &cut);
                CHECK_EQ(dem_slabs_step(slabs, 2000), DEM_OK);
                CHECK_EQ(dem_slabs_collect(slabs, other), DEM_OK);
                CHECK(dem_totals_get(other).centre[0] < 0.0055);   /* they lie where gravity is now */
                dem_slabs_destroy(slabs);
            }
            dem_world_destroy(w);
        }
        remove("build/tmp/gravity.dem");
    }
    remove(saved);
    TEST("when time step and modulus change in mid-run, friction holds grains on a slope and overlaps shrink") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_material_desc d = scene_stuff(1e6, 0.3, 0.8, 0.8);
        dem_world *world;
        dem_material m, other;
        dem_pair set, after;
        dem_totals before, now;
        dem_real dt;
        int k;
        world = dem_world_create(&desc);
        dem_world_gravity_set(world, at(9.81*sin(0.3), 0, -9.81*cos(0.3)));
        m = dem_material_add(world, &d);
        other = dem_material_add(world, &d);
        dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        for (k = 0; k < 10; k++) dem_sphere_add(world, m, DEM_R(0.005), at(0.02*k, 0, 0.00499));
        CHECK_EQ(dem_pair_get(world, m, other, &set), DEM_OK);
        set.friction = set.friction_static = DEM_R(0.123);
        CHECK_EQ(dem_pair_set(world, m, other, &set), DEM_OK);
        CHECK_EQ(dem_world_run(world, 0.5, 0, 0), DEM_OK);
        before = dem_totals_get(world);
        dt = dem_counters_get(world).dt;
        CHECK_EQ(dem_world_dt_set(world, -1), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "dt is -1 s");
        CHECK_EQ(dem_world_dt_set(world, dt/3), DEM_OK);
        CHECK_EQ(dem_world_run(world, 0.1, 0, 0), DEM_OK);
        CHECK_NEAR(dem_counters_get(world).dt, dt/3, 1e-6*(double)dt);
        CHECK_EQ(dem_world_dt_set(world, 100*dt), DEM_OK);
        CHECK_EQ(dem_world_step(world, 1), DEM_ERROR_TIME_STEP);
        CHECK_EQ(dem_world_dt_set(world, 0), DEM_OK);
        d.young *= 4;
        CHECK_EQ(dem_material_set(world, m, &d), DEM_OK);
        CHECK_EQ(dem_pair_get(world, m, other, &after), DEM_OK);
        CHECK(!memcmp(&after, &set, sizeof set));            /* what was set stays */
        CHECK_EQ(dem_pair_get(world, m, m, &after), DEM_OK);
        CHECK_REL(after.young_eff, 4*(double)set.young_eff, 1e-6);
        CHECK_EQ(dem_world_run(world, 0.5, 0, 0), DEM_OK);
        CHECK((double)dem_counters_get(world).dt < 0.7*(double)dt);
        now = dem_totals_get(world);
        CHECK_NEAR(now.centre[0], before.centre[0], 2e-5);   /* a spring forgotten lets all of them roll or slide */
        CHECK(now.centre[2] > before.centre[2]);             /* stiffer: they sink in less */
        d.density *= 2;
        CHECK_EQ(dem_material_set(world, m, &d), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "must stay 2500");
        d.density /= 2;
        d.restitution = 2;
        CHECK_EQ(dem_material_set(world, m, &d), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "dem_material_set: restitution is 2");
        CHECK_EQ(dem_material_get(world, m, &d), DEM_OK);
        CHECK_REL(d.young, 4e6, 1e-6);
        CHECK_REL(d.restitution, 0.3, 1e-6);
        dem_world_destroy(world);
    }
    TEST("a time step set in mid-run is in the checkpoint, and a world of the same desc resumes with it bit for bit") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world[2];
        int k;
        desc.gravity = at(0, 0, -9.81);
        for (k = 0; k < 2; k++) {
            dem_material m;
            world[k] = dem_world_create(&desc);
            m = scene_material(world[k], 1e6, 0.5, 0.3, 0);
            dem_wall_plane_add(world[k], m, at(0, 0, 0), at(0, 0, 1));
            dem_spheres_fill(world[k], m, DEM_R(0.005),
                             dem_region_make(box_of(-0.02, -0.02, 0, 0.02, 0.02, 0.08)), 30, 1);
        }
        CHECK_EQ(dem_world_run(world[0], 0.1, 0, 0), DEM_OK);
        CHECK_EQ(dem_world_dt_set(world[0], dem_counters_get(world[0]).dt/2), DEM_OK);
        CHECK_EQ(scene_step(world[0], 10), DEM_OK);
        CHECK_EQ(dem_checkpoint_write(world[0], saved), DEM_OK);
        CHECK_EQ(dem_checkpoint_read(world[1], saved), DEM_OK);
        for (k = 0; k < 2; k++) CHECK_EQ(scene_step(world[k], 500), DEM_OK);
        CHECK(dem_world_hash_get(world[0]) == dem_world_hash_get(world[1]));
        for (k = 0; k < 2; k++) dem_world_destroy(world[k]);
    }
    return test_end();
}
