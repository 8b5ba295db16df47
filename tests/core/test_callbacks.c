/* Functions of the user's that try to change the world while a public function calls them: refused with a message that
   says so, and the world stays as it was. One row for each public function and each kind of function that it calls;
   tests/run/test_changes.c has further rows, in a step. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

typedef enum caller { BELT, LEAD, CHECK_WORLD, FORCES, EFFECTS, TRIALS, ADVICE, SELECT, CALLERS } caller;
static const char *const callers[CALLERS] = {"dem_wall_surface_velocity_set", "dem_wall_motion_set", "dem_world_check",
    "dem_contacts_get", "dem_effects_get", "dem_trials_run", "dem_step_advice_get", "dem_bodies_select"};
typedef enum called { LAW, REGION, RATE, FIELD, BODY_FIELD, GROWTH, OBSERVER, ALLOCATION, KINDS } called;
static const char *const kinds[KINDS] = {"law", "region", "rate of a law", "force", "body force", "growth", "observer", "allocator"};

static struct { dem_world *world; dem_material stuff; dem_wall wall; called kind; int calls, done; } me;
/* Tries every kind of change, at the first calls. */
static void intrude(called kind) {
    dem_world *w = me.world;
    dem_motion still = DEM_MOTION;
    if (!w || kind != me.kind || me.calls > 2) return;
    me.calls++;
    me.done += dem_body_remove(w, dem_body_id_get(w, 0)) == DEM_OK;
    me.done += dem_sphere_add(w, me.stuff, DEM_R(1e-3), at(0, 0, 1)).slot > 0;
    me.done += dem_candidates_rebuild(w) == DEM_OK;
    me.done += dem_world_step(w, 1) == DEM_OK;
    me.done += dem_wall_remove(w, me.wall) == DEM_OK;
    me.done += dem_wall_motion_set(w, me.wall, &still) == DEM_OK;
    me.done += dem_wall_surface_velocity_set(w, me.wall, at(1, 0, 0)) == DEM_OK;
    me.done += dem_world_gravity_set(w, at(1, 2, 3)) == DEM_OK;
    me.done += dem_world_check(w, 0, 0) > 0;
    dem_world_destroy(w);                       /* the world must be there afterwards */
}
static void law(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    (void)memory;
    f->normal = 2000*c->overlap + DEM_R(0.01)*c->closing_speed;
    intrude(LAW);
}
static void rate(const dem_contact *c, dem_real *rates) { (void)c; rates[0] = 1; intrude(RATE); }
static int inside(dem_vec3 x, dem_real r, void *u) { (void)x; (void)r; (void)u; intrude(REGION); return 1; }
static dem_vec3 force(dem_vec3 x, dem_vec3 v, dem_real r, dem_real m, double t, void *u) {
    (void)x; (void)v; (void)r; (void)m; (void)t; (void)u;
    intrude(FIELD);
    return at(0, 0, 0);
}
static void body_force(const dem_body_state *b, dem_body id, double t, dem_vec3 *f, dem_vec3 *torque, void *u) {
    (void)b; (void)id; (void)t; (void)f; (void)torque; (void)u;
    intrude(BODY_FIELD);
}
static dem_real growth(const dem_body_state *b, dem_body id, double t, void *u) { (void)b; (void)id; (void)t; (void)u; intrude(GROWTH); return 0; }
static double observe(const dem_world *w, void *u) { (void)u; intrude(OBSERVER); return w->clock.time; }
static void *take(size_t size, void *u) { (void)u; intrude(ALLOCATION); return malloc(size); }
static void give(void *p, size_t size, void *u) { (void)size; (void)u; intrude(ALLOCATION); free(p); }

static void call(caller from) {
    dem_world *w = me.world;
    dem_motion lead = DEM_MOTION;
    dem_selection select;
    dem_region region = DEM_REGION;
    dem_trials_desc trials;
    static dem_trials out;
    static dem_contact_info found[100];
    dem_effect effects[DEM_EFFECTS];
    dem_observable time = {"time", "s", observe, 0, 1};
    dem_advice advice;
    dem_body ids[100];
    memset(&select, 0, sizeof select);
    memset(&trials, 0, sizeof trials);
    switch (from) {
    case BELT: dem_wall_surface_velocity_set(w, me.wall, at(0.1, 0, 0)); break;
    case LEAD:
        lead.kind = DEM_MOTION_TRANSLATING;
        lead.velocity.x = DEM_R(0.01);
        dem_wall_motion_set(w, me.wall, &lead);
        break;
    case CHECK_WORLD: dem_world_check(w, 0, 0); break;
    case FORCES: dem_contacts_get(w, found, 100); break;
    case EFFECTS: dem_effects_get(w, 0.02, effects); break;
    case TRIALS:
        trials.duration = 1e-3; trials.budget = 0.3; trials.seeds = 2;
        trials.observables[0] = time; trials.observable_count = 1;
        dem_trials_run(w, &trials, &out);
        break;
    case ADVICE: dem_step_advice_get(w, &advice); break;
    case SELECT:
        region.box = box_of(-1, -1, -1, 1, 1, 1); region.inside = inside;
        select.region = &region;
        dem_bodies_select(w, &select, ids, 100);
        break;
    default: break;
    }
}
/* The number of calls of `kind` from `from`; bodies, walls and steps stay, and no change was carried out. */
static int tried(caller from, called kind) {
    static const dem_real corners[12] = {DEM_R(-0.01), DEM_R(-0.01), 0, DEM_R(0.03), DEM_R(-0.01), 0, DEM_R(0.03),
                                         DEM_R(0.03), 0, DEM_R(-0.01), DEM_R(0.03), 0};
    static const int32_t triangles[6] = {0, 1, 2, 0, 2, 3};
    dem_world_desc d = DEM_WORLD_DESC;
    dem_feed_desc feed = DEM_FEED_DESC;
    dem_motion lead = DEM_MOTION;
    dem_mesh floor_;
    dem_world *w;
    int i;
    memset(&me, 0, sizeof me);
    d.gravity.z = DEM_R(-9.81); d.dt = DEM_R(5e-6); d.threads = 1;
    d.law = law; d.law_stiffness = 2000; d.law_memory = 4;
    if (kind == RATE) { d.body_reals = "heat"; d.law_who = 1; d.law_rate = rate; }
    if (kind == FIELD) d.force = force;
    if (kind == BODY_FIELD) d.body_force = body_force;
    if (kind == GROWTH) d.growth = growth;
    if (kind == ALLOCATION) { d.allocator.alloc_fn = take; d.allocator.free_fn = give; }
    w = dem_world_create(&d);
    me.stuff = scene_material(w, 5e6, 0.5, 0.3, 0);
    memset(&floor_, 0, sizeof floor_);
    floor_.vertex_count = 4; floor_.triangle_count = 2;
    floor_.vertices = (dem_real *)corners; floor_.triangles = (int32_t *)triangles;
    me.wall = dem_wall_mesh_add(w, me.stuff, &floor_);
    for (i = 0; i < 16; i++)
        dem_sphere_add(w, me.stuff, DEM_R(1e-3), at(0.00199*(i%4), 0.00199*(i/4), 0.00099));
    if (kind == REGION && from == CHECK_WORLD) {
        feed.material = me.stuff; feed.class_count = 1; feed.radius[0] = DEM_R(1e-3); feed.amount[0] = 10;
        feed.limited = 1; feed.start = 1;
        feed.box = box_of(0, 0, 0.005, 0.02, 0.02, 0.02); feed.inside = inside;
        CHECK(dem_feed_add(w, &feed).id > 0);
    }
    lead.kind = DEM_MOTION_TRANSLATING;
    for (i = 0; i < 3; i++) { CHECK_EQ(dem_wall_motion_set(w, me.wall, &lead), DEM_OK); CHECK_EQ(dem_world_step(w, 1), DEM_OK); }
    me.world = w;
    me.kind = kind;
    call(from);
    me.world = 0;
    CHECK_EQ(me.done, 0);
    CHECK_EQ(w->bodies.count, 16);
    CHECK_EQ((int)w->clock.steps, 3);
    CHECK(demi_wall_there(w, me.wall));
    CHECK(!w->look.calling.who);                /* no mark is left behind */
    if (me.calls && from != TRIALS) CHECK_STR(w->error, "called from a function that");
    if (me.done) printf("        from a %s in %s: %d changes were carried out\n", kinds[kind], callers[from], me.done);
    i = me.calls;
    dem_world_error_get(w);
    CHECK_EQ(dem_world_step(w, 2), DEM_OK);
    dem_world_destroy(w);
    return i;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("a user-defined function cannot change the world, whichever public function calls it") {
        int from, kind, calls[KINDS] = {0};
        for (from = 0; from < CALLERS; from++)
            for (kind = 0; kind < KINDS; kind++) {
                const int n = tried((caller)from, (called)kind);
                calls[kind] += n;
                if (kind == LAW && from < FORCES && from != CHECK_WORLD) CHECK(n > 0);
                if (kind == REGION && (from == CHECK_WORLD || from == SELECT)) CHECK(n > 0);
            }
        for (kind = 0; kind < KINDS; kind++) CHECK(calls[kind] > 0);
    }
    return test_end();
}
