/* bench.c - how fast dem.h is, and what each choice costs. MIT licence.

   make bench                    all of it in under three minutes, in double, in single and built with -O2
   build/bench --scene bed       one scene: rate, threads, memory, ledger
   build/bench --scene effects   what effects, laws, searches and integrators cost, present and absent; --effect NAME
   build/bench --scene walls     cost of a contact with a wall, relative to one of two beads and over facets per grain
   build/bench --scene sizes     cost of a grain among much larger ones, by levels and on one grid
   build/bench --count NAME      takes a few steps of one scene for bench/instructions.sh, which counts their instructions
   build/bench --settle bed      computes a start state again (minutes): build/out/bench/bed_20k.txt

   The program measures the wall time of loops of steps after 100 untimed ones. Variants run in turns, A B A B. It prints
   medians and half the range. Ratios need a quiet machine: `spread` shows how quiet it was. With --cpu it measures
   processor time, for one thread on a busy machine. */
#include "dem.h"
#include <math.h>
/* Hertz with a spring of Cundall and Strack, written as a user would, to measure the cost of a user-defined law: called by
   pointer, and named by DEM_LAW. */
DEM_INLINE void bench_law(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const dem_real d = c->overlap > 0 ? c->overlap : 0;
    const dem_real root = (dem_real)sqrt((double)d), fourth = (dem_real)sqrt((double)root);
    const dem_real kt = c->kt*root, ct = c->ct*fourth, dt = c->dt;
    const dem_vec3 v = c->slip, w = c->slip_step;
    dem_vec3 s = dem_memory_rotate(c, dem_vec3_make(memory[0], memory[1], memory[2]));
    dem_real x, y, z, limit, size, cut, give;
    s = dem_vec3_make(s.x + w.x*dt, s.y + w.y*dt, s.z + w.z*dt);
    f->normal = c->kn*root*d + c->cn*fourth*c->closing_speed;
    limit = f->normal > 0 ? c->friction*f->normal : 0;
    x = -kt*s.x - ct*v.x; y = -kt*s.y - ct*v.y; z = -kt*s.z - ct*v.z;
    size = (dem_real)sqrt((double)(x*x + y*y + z*z));
    cut = size > limit ? limit/(size + DEM_R(1e-30)) : 1;
    give = (1 - cut)*dt/(kt*dt + ct + DEM_R(1e-30));                /* shared, as dem.h has it */
    f->tangent = dem_vec3_make(x*cut, y*cut, z*cut);
    memory[0] = s.x + give*x; memory[1] = s.y + give*y; memory[2] = s.z + give*z;
}
#define DEM_LAW bench_law
#define DEM_IMPLEMENTATION
#include "dem.h"
#include "examples/study.h"
#include "bench/measure.h"
#include "bench/scenes.h"

#ifndef BENCH_LABEL             /* after the precision in names: ".O2"                          */
#define BENCH_LABEL ""
#endif
enum { WARM_UP = 100, MOST_LOOPS = BENCH_MOST_LOOPS };

static const char *scene_name = "all", *data_folder = "bench/data", *out = "", *settle = "", *codes = "", *effect_asked = "", *counted = "";
static int steps_asked, repeat_asked, threads_asked = 2, quick, full, cpu, raw, brief;
static double skin_asked;
static int cuts_asked;

/* ---- timing ---- */

static double now(void) { return cpu ? (double)clock()/CLOCKS_PER_SEC : study_clock(); }

static int steps_of(const bench_scene *s) { /* of one timed loop                                   */
    const int steps = bench_is(s, "gas") ? 300 : 80;
    return steps_asked ? steps_asked : full ? 10*steps : steps;
}
static int repeats(void) { return repeat_asked ? repeat_asked : full ? 9 : 5; }

/* Seconds of one loop; -1 and a sentence when the run breaks. */
static double loop(const char *what, dem_world *world, int steps) {
    const double begun = now();
    if (dem_world_step(world, steps) == DEM_OK) return now() - begun;
    study_fail("%s: %s", what, dem_world_error_get(world));
    return -1;
}
static dem_world *warm(const char *what, const bench_scene *s, const bench_choice *o) {
    dem_world *world = bench_world(s, o);
    if (world && loop(what, world, WARM_UP) < 0) { dem_world_destroy(world); world = 0; }
    return world;
}

/* Loops of two worlds in turns; b may be null. Answers how many turns: fewer than asked, but no fewer than
   three, when they take long (a busy machine); 0 when a run broke. */
static int take_turns(const char *what, dem_world *a, dem_world *b, int steps, double *ta, double *tb) {
    const double begun = study_clock();
    int r;
    for (r = 0; r < repeats(); r++) {
        if (r >= 3 && !repeat_asked && !full && study_clock() - begun > 4) break;
        if ((ta[r] = loop(what, a, steps)) < 0) return 0;
        if (b && (tb[r] = loop(what, b, steps)) < 0) return 0;
    }
    return r;
}

/* Names of results begin with scene, precision and build: bed.double.O2. */
static void names_begin(const char *scene) {
    const char *precision = sizeof(dem_real) == sizeof(float) ? "single" : "double";
    if (*scene) snprintf(study.prefix, sizeof study.prefix, "%s.%s%s.", scene, precision, BENCH_LABEL);
    else study.prefix[0] = 0;
}

/* ---- one scene: rate, threads, ledger, memory ---- */

static void measure(const bench_scene *s) {
    bench_choice choice = BENCH_CHOICE;
    dem_world *one, *other;
    dem_counters c;
    double ta[MOST_LOOPS], tb[MOST_LOOPS], work;
    const int steps = steps_of(s);
    int turns;
    uint64_t before;
    char name[64];
    names_begin(s->name);
    work = (double)s->count*steps;
    choice.skin = skin_asked*s->radius;
    one = warm(s->name, s, &choice);
    if (!one) return;
    choice.threads = threads_asked;
    if (threads_asked > 1 && !DEMI_OPENMP) printf("SKIP: built without OpenMP, no rates on %d threads\n", threads_asked);
    other = threads_asked > 1 && DEMI_OPENMP && !cpu ? warm(s->name, s, &choice) : 0;
    before = dem_counters_get(one).rebuilds;
    turns = take_turns(s->name, one, other, steps, ta, tb);
    if (turns) {
        bench_result_rate("rate", work/bench_median(ta, turns));
        bench_result_short("rate_spread", bench_spread(ta, turns), "%");
        c = dem_counters_get(one);
        if (!brief) {
            bench_result_short("contacts_per_bead", 2.0*c.contacts/s->count, "");
            bench_result_short("pairs_per_bead", (double)c.candidates/s->count, "");
            bench_result_short("steps_per_rebuild", (double)steps*turns/
                         (double)(c.rebuilds > before ? c.rebuilds - before : 1), "");
            bench_result_short("skin", 1e3*(double)c.skin, "mm");
            if (bench_is(s, "bed")) bench_result_short("memory_per_bead", (double)c.memory/s->count, "byte");
        }
    }
    if (turns && other) {
        snprintf(name, sizeof name, "threads%d.rate", threads_asked);
        bench_result_rate(name, work/bench_median(tb, turns));
        snprintf(name, sizeof name, "threads%d.speedup", threads_asked);
        bench_result_short(name, bench_median_ratio(ta, tb, turns), "");
        snprintf(name, sizeof name, "threads%d.rate_spread", threads_asked);
        bench_result_short(name, bench_spread(tb, turns), "%");
        if (dem_world_hash_get(one) != dem_world_hash_get(other))
            study_fail("%s: 1 and %d threads do not agree to the last bit", s->name, threads_asked);
    }
    if (other) dem_world_destroy(other);
    choice.threads = 0;
    choice.ledger = 1;
    other = brief ? 0 : warm(s->name, s, &choice);
    if (other && (turns = take_turns(s->name, one, other, steps, ta, tb)) > 0)
        bench_result_short("ledger_cost", bench_median_ratio(tb, ta, turns), "of the default");
    if (other) dem_world_destroy(other);
    dem_world_destroy(one);
    names_begin("");
}

/* ---- the cost of an effect: time of a step with it over that without it, on the same scene in turns; and its cost where
   it is switched on but has no cause (no friction in any pair, a field that is over), which should be none ---- */

typedef struct effect_row { const char *name, *scene, *about, *against; bench_choice with, without, absent; } effect_row;
#define NO_FRICTION {.tangent = DEM_TANGENT_NONE}
static void bench_law_called(const dem_contact *c, dem_real *memory, dem_contact_force *f) { bench_law(c, memory, f); }
static void bench_law_flows(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const dem_real flow = c->who.reals_b[0] - c->who.reals_a[0];
    bench_law(c, memory, f);
    c->who.rate_a[0] += flow;
    c->who.rate_b[0] -= flow;
}
DEM_LAW_ROWS(bench_law_rows, bench_law, 3)
static const effect_row effect_rows[] = {
    {"friction", "bed", "spring friction, which holds grains at rest", "no friction",
     {0}, NO_FRICTION, {.tangent = DEM_TANGENT_SPRING, .smooth = 1}},
    {"tangent.viscous", "bed", "viscous friction (heaps creep)", "spring friction",
     {.tangent = DEM_TANGENT_VISCOUS}, {0}, {0}},
    {"tangent.step", "bed", "spring of one step, as in [MIL] (heaps creep)", "spring friction",
     {.tangent = DEM_TANGENT_STEP}, {0}, {0}},
    {"tangent.mindlin", "bed", "Mindlin's friction, whose stiffness follows the overlap", "spring friction",
     {.tangent = DEM_TANGENT_MINDLIN}, {0}, {0}},
    {"tangent.mindlin_rescaled", "bed", "the same, rescaled (unloading creates no energy)", "spring friction",
     {.tangent = DEM_TANGENT_MINDLIN_RESCALED}, {0}, {0}},
    {"normal.linear", "bed", "linear spring: contact time independent of speed", "Hertz",
     {.normal = DEM_NORMAL_LINEAR}, {0}, {0}},
    {"normal.hysteretic", "bed", "hysteretic law: loading and unloading on two lines", "linear spring",
     {.adhesion = 1}, {.normal = DEM_NORMAL_LINEAR}, {0}},
    {"adhesion", "bed", "hysteretic law with adhesion", "hysteretic law",
     {.adhesion = 2}, {.adhesion = 1}, {0}},
    {"rolling.step", "bed", "rolling resistance as in [MIL]", "no rolling resistance",
     {.rolling = DEM_ROLLING_STEP, .rolling_friction = 0.1}, {0}, {.rolling = DEM_ROLLING_STEP}},
    {"rolling.constant", "bed", "constant rolling torque", "no rolling resistance",
     {.rolling = DEM_ROLLING_CONSTANT, .rolling_friction = 0.1}, {0}, {.rolling = DEM_ROLLING_CONSTANT}},
    {"rolling.epsd", "bed", "rolling resistance that holds a grain on a slope", "no rolling resistance",
     {.rolling = DEM_ROLLING_EPSD, .rolling_friction = 0.1}, {0}, {.rolling = DEM_ROLLING_EPSD}},
    {"own_law.inlined", "bed", "Hertz and spring friction as a user-defined law, named by DEM_LAW", "built-in laws",
     {.law = bench_law}, {0}, {0}},
    {"own_law.rows", "bed", "the same law by pointer, row by row (DEM_LAW_ROWS)", "built-in laws",
     {.law = bench_law_called, .rows = bench_law_rows}, {0}, {0}},
    {"own_law.called", "bed", "the same law by pointer, contact by contact", "built-in laws",
     {.law = bench_law_called}, {0}, {0}},
    {"own_law.who", "bed", "ids, radii, masses, contact point and time for a law by pointer", "own_law.called",
     {.law = bench_law_called, .who = 1}, {.law = bench_law_called}, {0}},
    {"body_reals", "bed", "a number on every grain, which a law exchanges between them", "own_law.who",
     {.law = bench_law_flows, .who = 1, .reals = 1}, {.law = bench_law_called, .who = 1},
     {.law = bench_law_called, .who = 1, .reals = 1}},
    {"own_law.range", "bed", "a law called from 0.05 radii before contact", "own_law.inlined",
     {.law = bench_law, .range = 0.05}, {.law = bench_law}, {0}},
    {"ledger", "bed", "energy balance, checked at every step", "no ledger",
     {.ledger = 1}, {0}, {0}},
    {"events", "bed", "every contact recorded from its beginning to its end", "ledger",
     {.ledger = 2}, {.ledger = 1}, {0}},
    {"one_unlike", "bed", "one grain unlike the others", "equal grains",
     {.mixed = 1}, {0}, {0}},
    {"two_species", "bed", "two sizes (or materials), half of the grains each", "equal grains",
     {.mixed = 2}, {0}, {0}},
    {"all_unlike", "bed", "a different size for every grain", "equal grains",
     {.mixed = 3}, {0}, {0}},
    {"memory", "bed", "spring friction, which has a contact history", "viscous friction",
     {0}, {.tangent = DEM_TANGENT_VISCOUS}, {0}},
    {"ellipsoids", "bed", "beads as ellipsoids of three equal axes", "spheres",
     {.shaped = 1}, {0}, {0}},
    {"clusters", "bed", "beads as clusters of one sphere", "spheres",
     {.shaped = 2}, {0}, {0}},
    {"clusters.members", "bed", "the same, each computed as a member of a larger cluster is", "spheres",
     {.shaped = 3}, {0}, {0}},
    {"clusters.one", "bed", "one cluster among spheres", "spheres",
     {.shaped = 4}, {0}, {0}},
    {"orientation", "bed", "orientations of spheres", "no orientations",
     {.orientations = 1}, {0}, {0}},
    {"periodicity", "gas", "periodic box", "open box",
     {0}, {.open = 1}, {0}},
    {"field", "bed", "solid fraction and velocity on a grid, every 100 steps", "no field",
     {.field = 1}, {0}, {.field = 2}},
    {"feed", "drum", "a bead fed every fourth step", "no feed",
     {.feed = 50000}, {0}, {.feed = 1e-3}},
    {"outlet", "drum", "removal of beads that fly through the middle", "no outlet",
     {.outlet = 1}, {0}, {.outlet = 2}},
    {"servo", "bed", "a servo wall that presses the bed with 500 Pa", "the same wall at rest",
     {.lid = 2}, {.lid = 1}, {0}},
    {"integrator.leapfrog", "bed", "the path of velocity Verlet", "velocity Verlet",
     {.integrator = DEM_INTEGRATOR_LEAPFROG}, {0}, {0}},
    {"integrator.position_verlet", "bed", "the path of velocity Verlet", "velocity Verlet",
     {.integrator = DEM_INTEGRATOR_POSITION_VERLET}, {0}, {0}},
    {"integrator.symplectic_euler", "bed", "first order, energy bounded", "velocity Verlet",
     {.integrator = DEM_INTEGRATOR_SYMPLECTIC_EULER}, {0}, {0}},
    {"integrator.forward_euler", "bed", "first order, gains energy", "velocity Verlet",
     {.integrator = DEM_INTEGRATOR_FORWARD_EULER}, {0}, {0}},
    {"skin0", "bed", "list rebuilt at every step", "chosen skin",
     {.skin = -1}, {0}, {0}},
    {"search.linked_list", "drum", "linked linear list, sorted along each axis [ALK07]", "grid",
     {.search = DEM_SEARCH_LINKED_LIST}, {0}, {0}},
    {"search.bins", "drum", "bins, for bodies of very different extent [MAZ11]", "grid",
     {.search = DEM_SEARCH_BINS}, {0}, {0}},
    {"search.all_pairs", "drum", "all pairs, the reference of the tests", "grid",
     {.search = DEM_SEARCH_ALL_PAIRS, .every = 18}, {.every = 18}, {0}}, /* of 1000 */
};

/* Time of a step of the one over that of the other, in turns; 0 when a run broke. */
static double effect_ratio(const char *name, const bench_scene *s, const bench_choice *with, const bench_choice *without,
                           double *spread) {
    double ta[MOST_LOOPS], tb[MOST_LOOPS], ratio[MOST_LOOPS];
    const int many = s->count/(with->every > 1 ? with->every : 1), full_loop = steps_of(s)/2 + 1;
    const int steps = many < 5000 && !steps_asked ? 4*full_loop : full_loop;
    dem_world *a = warm(name, s, without), *b = a ? warm(name, s, with) : 0;
    const int turns = b ? take_turns(name, a, b, steps, ta, tb) : 0;
    int r;
    for (r = 0; r < turns; r++) ratio[r] = tb[r]/ta[r];
    if (a) dem_world_destroy(a);
    if (b) dem_world_destroy(b);
    *spread = turns ? bench_spread(ratio, turns) : 0;
    return turns ? bench_median(ratio, turns) : 0;
}
/* Adds a row to the table of numbers, and to the page where the cost differs from 1 by more than its spread; otherwise the
   name is appended to `hidden`. */
static void effect(const effect_row *row, const bench_scene *s, FILE *page, FILE *data, char *hidden, size_t room) {
    static const bench_choice none = {0};
    const int many = s->count/(row->with.every > 1 ? row->with.every : 1);
    double spread, price = effect_ratio(row->name, s, &row->with, &row->without, &spread), absent = 0;
    char unit[64], name[64];
    if (!(price > 0)) return;
    snprintf(unit, sizeof unit, "of the step without (%s, %d, +- %.0f %%)", s->name, many, spread);
    snprintf(name, sizeof name, "effect.%s.price", row->name);
    bench_result_short(name, price, unit);
    if (data) fprintf(data, "%s,\"%s\",%s,%s,%d,%.2f,%.0f,", row->name, row->about, row->against, s->name, many, price, spread);
    if (page && fabs(price - 1) > spread/100)
        fprintf(page, "| `%s` | %s | %s | %s | %d | %.2f | %.0f |\n", row->name, row->about, row->against, s->name, many, price,
                spread);
    else snprintf(hidden + strlen(hidden), room - strlen(hidden), "%s`%s`", *hidden ? ", " : "", row->name);
    if (memcmp(&row->absent, &none, sizeof none)) {
        absent = effect_ratio(row->name, s, &row->absent, &row->without, &spread);
        snprintf(unit, sizeof unit, "of the step without (+- %.0f %%)", spread);
        snprintf(name, sizeof name, "effect.%s.absent_price", row->name);
        if (absent > 0) bench_result_short(name, absent, unit);
    }
    if (data && absent > 0) fprintf(data, "%.2f,%.0f\n", absent, spread);
    else if (data) fprintf(data, ",\n");
}

static void effects(double load) {
    bench_scene scenes[3];
    char hidden[1000] = "";
    FILE *page = bench_page_open(), *data = bench_data_open("effects.csv", "make bench-pages PAGES=effects",
        "effect,description,compared with,scene,grains,time of a step [compared with = 1],spread [%],"
        "time when on but without a cause [compared with = 1],spread [%]");
    size_t i;
    int k;
    scenes[0] = bench_scene_read(data_folder, "bed");
    scenes[1] = bench_scene_read(data_folder, "drum");
    scenes[2] = bench_scene_read(data_folder, "gas");
    if (page) {
        bench_page_machine(page, load);
        fprintf(page, "| effect or choice | description | compared with | scene | grains | time of a step [compared with = 1] | "
                "spread [%%] |\n|---|---|---|---|---|---|---|\n");
    }
    for (i = 0; i < sizeof effect_rows/sizeof *effect_rows; i++)
        for (k = 0; k < 3; k++)
            if (bench_is(&scenes[k], effect_rows[i].scene) && strstr(effect_rows[i].name, effect_asked))
                effect(&effect_rows[i], &scenes[k], page, data, hidden, sizeof hidden);
    if (page && *hidden) fprintf(page, "\nThese differ from 1 by less than their spread: %s.\n", hidden);
    study_close(page, "page.md");
    study_close(data, "effects.csv");
    for (k = 0; k < 3; k++) bench_scene_free(&scenes[k]);
}

/* ---- what a contact with a wall costs ---- */

/* Beads slide slowly and do not touch each other. Each has one contact: with a fixed bead below it (a pair),
   with a plane, with a wide cylinder, or with a floor of more and more triangles. The time of the same beads
   without contacts is subtracted. All worlds have the fixed beads, out of reach unless they are the partners. */
enum { WALLS_SIDE = 64, WALLS_BEADS = WALLS_SIDE*WALLS_SIDE };
typedef enum walls_kind { WALLS_NONE, WALLS_PAIR, WALLS_PLANE, WALLS_CYLINDER, WALLS_MESH } walls_kind;
static int walls_mesh(dem_world *world, dem_material glass, int n, double side) {
    dem_mesh mesh;
    int i, j, k = 0, ok;
    mesh.vertex_count = (n + 1)*(n + 1);
    mesh.triangle_count = 2*n*n;
    mesh.vertices = (dem_real *)study_alloc((size_t)mesh.vertex_count*3, sizeof(dem_real));
    mesh.triangles = (int32_t *)study_alloc((size_t)mesh.triangle_count*3, sizeof(int32_t));
    for (j = 0; j <= n; j++)
        for (i = 0; i <= n; i++) {
            dem_real *x = mesh.vertices + 3*(i + (n + 1)*j);
            x[0] = (dem_real)(side*i/n);
            x[1] = (dem_real)(side*j/n);
            x[2] = 0;
        }
    for (j = 0; j < n; j++)
        for (i = 0; i < n; i++) {
            const int a = i + (n + 1)*j, c = a + n + 1;
            const int corners[6] = {a, a + 1, c + 1, a, c + 1, c};
            int e;
            for (e = 0; e < 6; e++) mesh.triangles[k++] = corners[e];
        }
    ok = dem_wall_mesh_add(world, glass, &mesh).id != 0;
    free(mesh.vertices);
    free(mesh.triangles);
    return ok;
}
static dem_world *walls_world(walls_kind kind, int n) {
    const double r = BENCH_RADIUS, side = 2.1*r*WALLS_SIDE, drum = 4*side, deep = 1e-4*r;
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc m = DEM_MATERIAL_DESC;
    dem_world *world;
    dem_material glass;
    int i, ok = 1;
    desc.threads = 1;
    desc.dt = (dem_real)BENCH_DT;
    desc.skin = DEM_R(5e-5);
    if (kind != WALLS_NONE) desc.gravity.z = (dem_real)-BENCH_GRAVITY;
    m.density = (dem_real)BENCH_DENSITY;
    m.restitution = (dem_real)BENCH_RESTITUTION;
    m.young = (dem_real)BENCH_YOUNG;
    m.poisson = (dem_real)BENCH_POISSON;
    m.friction = (dem_real)BENCH_FRICTION;
    world = dem_world_create(&desc);
    glass = dem_material_add(world, &m);
    if (kind == WALLS_PLANE) ok = dem_wall_plane_add(world, glass, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1)).id != 0;
    if (kind == WALLS_CYLINDER)
        ok = dem_wall_cylinder_add(world, glass, dem_vec3_make((dem_real)(side/2), 0, (dem_real)drum), dem_vec3_make(0, 1, 0),
                              (dem_real)drum, 1).id != 0;
    if (kind == WALLS_MESH) ok = walls_mesh(world, glass, n, side);
    for (i = 0; i < WALLS_BEADS && ok; i++) {
        const double x = 2.1*r*(i%WALLS_SIDE + 0.5), y = 2.1*r*(i/WALLS_SIDE + 0.5), off = x - side/2;
        const double z = kind == WALLS_CYLINDER ? drum - sqrt((drum - r + deep)*(drum - r + deep) - off*off) : r - deep;
        int k;
        for (k = 0; k < 2 && ok; k++) {         /* the bead; the fixed one below it */
            const double at = k ? kind == WALLS_PAIR ? -r : -9*r : z;
            const dem_body bead = dem_sphere_add(world, glass, (dem_real)r, dem_vec3_make((dem_real)x, (dem_real)y, (dem_real)at));
            dem_body_state state;
            ok = dem_body_get(world, bead, &state) == DEM_OK;
            state.velocity.y = k ? 0 : DEM_R(0.002);
            state.fixed = k;
            ok = ok && dem_body_set(world, bead, &state) == DEM_OK;
        }
    }
    if (ok && dem_world_step(world, WARM_UP) == DEM_OK) return world;
    study_fail("walls: %s", dem_world_error_get(world));
    dem_world_destroy(world);
    return 0;
}
typedef struct walls_row { const char *name; walls_kind kind; int n; } walls_row;
static const walls_row walls_rows[] = {
    {"pair", WALLS_PAIR, 0}, {"plane", WALLS_PLANE, 0}, {"cylinder", WALLS_CYLINDER, 0}, {"mesh_242", WALLS_MESH, 11},
    {"mesh_5000", WALLS_MESH, 50}, {"mesh_50000", WALLS_MESH, 158}, {"mesh_500000", WALLS_MESH, 500}};
static void walls(void) {
    const int steps = steps_asked ? steps_asked : full ? 1000 : 100;
    const walls_row *rows = walls_rows;
    double pair = 0;
    size_t i;
    for (i = 0; i < sizeof walls_rows/sizeof *walls_rows; i++) {
        dem_world *air = walls_world(WALLS_NONE, 0), *floor = air ? walls_world(rows[i].kind, rows[i].n) : 0;
        double ta[MOST_LOOPS], tb[MOST_LOOPS], each[MOST_LOOPS];
        int r, turns = floor ? take_turns("walls", air, floor, steps, ta, tb) : 0;
        char name[64];
        if (turns) {
            const dem_counters c = dem_counters_get(floor);
            const int contacts = c.contacts + c.wall_contacts;
            for (r = 0; r < turns; r++) each[r] = 1e9*(tb[r] - ta[r])/steps/(contacts ? contacts : 1);
            snprintf(name, sizeof name, "walls.%s.facets_per_bead", rows[i].name);
            if (rows[i].n) bench_result_short(name, 2.0*rows[i].n*rows[i].n/WALLS_BEADS, "");
            snprintf(name, sizeof name, "walls.%s.contacts_per_bead", rows[i].name);
            bench_result_short(name, (double)contacts/WALLS_BEADS, "");
            snprintf(name, sizeof name, "walls.%s.contact", rows[i].name);
            bench_result_short(name, bench_median(each, turns), "ns");
            if (!i) pair = bench_median(each, turns);
            snprintf(name, sizeof name, "walls.%s.over_pair", rows[i].name);
            if (i) bench_result_short(name, bench_median(each, turns)/pair, "");
        }
        if (air) dem_world_destroy(air);
        if (floor) dem_world_destroy(floor);
    }
}

/* ---- what a grain costs among much larger ones ---- */

/* As many small grains in each world, shaken, in a close packing with gaps of 1 %: alone in a periodic
   cube; there with 20 ten times as large, half of what is solid; and between three a hundred times as
   large, in the open. */
enum { SIZES_SMALL = 20000, SIZES_LARGE = 20, SIZES_WORLDS = 5 };
typedef struct sizes_place { int large; double x[SIZES_LARGE][3], radius, centre[3], reach; } sizes_place;
static int sizes_inside(dem_vec3 c, dem_real radius, void *user) {
    const sizes_place *p = (const sizes_place *)user;
    const double x[3] = {(double)c.x, (double)c.y, (double)c.z};
    double d2 = 0;
    int i, k;
    for (k = 0; k < 3; k++) d2 += (x[k] - p->centre[k])*(x[k] - p->centre[k]);
    if (p->reach > 0 && d2 > p->reach*p->reach) return 0;
    for (i = 0; i < p->large; i++) {
        const double apart = p->radius + 1.01*(double)radius;
        for (d2 = 0, k = 0; k < 3; k++) d2 += (x[k] - p->x[i][k])*(x[k] - p->x[i][k]);
        if (d2 < apart*apart) return 0;
    }
    return 1;
}
/* Where the large ones stand, and the edge of the box (m) that leaves room for the small ones. */
static double sizes_lay(sizes_place *p, int ratio) {
    const double r = BENCH_RADIUS, each = pow(2*1.01*r, 3)/sqrt(2.0);
    double side = pow(SIZES_SMALL*each*(ratio == 10 ? 2.3 : 1.13), 1.0/3);
    int i, k;
    memset(p, 0, sizeof *p);
    p->radius = ratio*r;
    p->large = ratio == 10 ? SIZES_LARGE : ratio == 100 ? 3 : 0;
    for (i = 0; i < p->large && ratio == 10; i++) {    /* 20 of the 27 places of a lattice */
        const int at[3] = {i%3, i/3%3, i/9};
        for (k = 0; k < 3; k++) p->x[i][k] = (at[k] + 0.5)*side/3;
    }
    if (ratio == 100) side = 4*p->radius;
    for (i = 0; i < p->large && ratio == 100; i++) {   /* a triangle, a hair apart; small ones in the middle */
        const double angle = 2*3.14159265358979323846*i/3;
        for (k = 0; k < 3; k++) p->centre[k] = side/2;
        for (k = 0; k < 3; k++)
            p->x[i][k] = p->centre[k] + (k == 2 ? 0 : 1.17*p->radius*(k ? sin(angle) : cos(angle)));
        p->reach = 0.5*p->radius;
    }
    return side;
}
static dem_world *sizes_world(int ratio, int mixed, dem_search search) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc m = DEM_MATERIAL_DESC;
    dem_material material;
    dem_world *world;
    sizes_place place;
    const double r = BENCH_RADIUS, side = sizes_lay(&place, ratio);
    uint64_t seed = 7;
    int i, k;
    desc.threads = 1;
    desc.search = search;
    desc.dt = (dem_real)BENCH_DT;
    desc.domain = dem_box_make(0, 0, 0, (dem_real)side, (dem_real)side, (dem_real)side);
    for (k = 0; k < 3 && ratio < 100; k++) desc.boundary[k] = DEM_BOUNDARY_PERIODIC;
    world = dem_world_create(&desc);
    if (!world) { study_fail("sizes: %s", dem_world_create_error_get(&desc)); return 0; }
    m.density = (dem_real)BENCH_DENSITY;
    m.young = (dem_real)BENCH_YOUNG;
    m.poisson = (dem_real)BENCH_POISSON;
    m.restitution = DEM_R(0.9);
    m.friction = (dem_real)BENCH_FRICTION;
    material = dem_material_add(world, &m);
    k = dem_spheres_pack(world, material, (dem_real)r, (dem_real)(0.02*r),
                         dem_region_inside_make(desc.domain, sizes_inside, &place), SIZES_SMALL);
    if (k < SIZES_SMALL) study_fail("sizes: only %d of %d small grains found a place", k, (int)SIZES_SMALL);
    for (i = 0; i < k; i++) {
        dem_body_state state;
        const dem_body body = dem_body_id_get(world, i);
        dem_body_get(world, body, &state);
        state.velocity = dem_vec3_make((dem_real)(0.2*demi_uniform(&seed) - 0.1), (dem_real)(0.2*demi_uniform(&seed) - 0.1),
                                       (dem_real)(0.2*demi_uniform(&seed) - 0.1));
        dem_body_set(world, body, &state);
    }
    for (i = 0; i < place.large; i++)
        dem_sphere_add(world, material, (dem_real)place.radius, dem_vec3_make((dem_real)place.x[i][0],
                       (dem_real)place.x[i][1], (dem_real)place.x[i][2]));
    if (mixed)                          /* one smaller by a thousandth: no longer all alike         */
        dem_sphere_add(world, material, (dem_real)(0.999*r), dem_vec3_make((dem_real)side - (dem_real)r/4,
                       (dem_real)side - (dem_real)r/4, (dem_real)side - (dem_real)r/4));
    if (loop("sizes", world, WARM_UP) < 0) { dem_world_destroy(world); return 0; }
    return world;
}

static void sizes(void) {
    static const struct { const char *name; int ratio, mixed; dem_search search; } row[SIZES_WORLDS] = {
        {"alike", 1, 0, DEM_SEARCH_AUTO}, {"mixed_kernel", 1, 1, DEM_SEARCH_AUTO},
        {"ratio10", 10, 0, DEM_SEARCH_AUTO}, {"ratio100", 100, 0, DEM_SEARCH_AUTO},
        {"ratio10.grid", 10, 0, DEM_SEARCH_GRID}}; /* slow: two turns tell enough */
    static double t[SIZES_WORLDS][MOST_LOOPS];
    dem_world *world[SIZES_WORLDS];
    const int steps = steps_asked ? steps_asked : full ? 800 : 160;
    int i, k, turns = repeats(), ok = 1;
    for (i = 0; i < SIZES_WORLDS; i++) ok = (world[i] = sizes_world(row[i].ratio, row[i].mixed, row[i].search)) != 0 && ok;
    for (k = 0; k < turns && ok; k++)
        for (i = 0; i < SIZES_WORLDS && ok; i++) {
            if (row[i].search == DEM_SEARCH_GRID && k > 1) continue;
            t[i][k] = loop(row[i].name, world[i], steps);
            ok = t[i][k] >= 0;
            t[i][k] /= (double)dem_body_counts_get(world[i]).present*steps;
        }
    names_begin("sizes");
    for (i = 0; i < SIZES_WORLDS && ok; i++) {
        const dem_counters c = dem_counters_get(world[i]);
        const double count = (double)dem_body_counts_get(world[i]).present;
        char name[64];
        if (row[i].search == DEM_SEARCH_GRID && turns > 2) turns = 2;  /* the last row */
        snprintf(name, sizeof name, "%s.rate", row[i].name);
        bench_result_rate(name, 1/bench_median(t[i], turns));
        snprintf(name, sizeof name, "%s.cost", row[i].name);
        if (i) bench_result_short(name, bench_median_ratio(t[i], t[0], turns), "of monodisperse, per grain");
        snprintf(name, sizeof name, "%s.cost_in_kernel", row[i].name);
        if (i > 1) bench_result_short(name, bench_median_ratio(t[i], t[1], turns),
                                      "of monodisperse in the same kernel, per grain");
        if (brief || i > 3) continue;
        snprintf(name, sizeof name, "%s.contacts_per_grain", row[i].name);
        bench_result_short(name, 2*c.contacts/count, "");
        snprintf(name, sizeof name, "%s.steps_per_rebuild", row[i].name);
        bench_result_short(name, (double)c.steps/(double)c.rebuilds, "");
    }
    names_begin("");
    for (i = 0; i < SIZES_WORLDS; i++) if (world[i]) dem_world_destroy(world[i]);
}

/* ---- start states, made with dem.h itself ---- */

static double uniform(void) { /* 0..1; splitmix64 */
    static uint64_t state = 20000;
    uint64_t z = (state += UINT64_C(0x9E3779B97F4A7C15));
    z = (z ^ (z >> 30))*UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27))*UINT64_C(0x94D049BB133111EB);
    return (double)((z ^ (z >> 31)) >> 11)/9007199254740992.0;
}
static double gaussian(void) { return sqrt(-2*log(1 - uniform()))*cos(2*3.14159265358979323846*uniform()); }

typedef struct drag { double rate; } drag; /* 1/s */
static dem_vec3 drag_force(dem_vec3 x, dem_vec3 v, dem_real radius, dem_real mass, double time, void *user) {
    const dem_real c = -mass*(dem_real)((const drag *)user)->rate;
    (void)x; (void)radius; (void)time;
    return dem_vec3_make(c*v.x, c*v.y, c*v.z);
}

/* Runs in pieces, with a progress line. */
static int run(dem_world *world, const char *what, int steps) {
    int done;
    study_progress(what, 0, 0);
    for (done = 0; done < steps; done += 200) {
        if (loop(what, world, steps - done < 200 ? steps - done : 200) < 0) return 0;
        study_progress(what, (done + 200.0)/steps < 1 ? (done + 200.0)/steps : 1,
                       (double)dem_body_counts_get(world).present*(done + 200.0));
    }
    return 1;
}

static void settle_scene(const char *name) {
    bench_choice choice = BENCH_CHOICE;
    drag brake = {0};
    bench_scene s = bench_scene_make(name, !strcmp(name, "bed") ? 20000 : !strcmp(name, "drum") ? 18000 : 32768);
    const double r = s.radius, spin_up = 0.302;
    dem_world *world;
    int i, c, count = 0, layer, x, y, z;
    double mean[3] = {0, 0, 0};
    choice.threads = threads_asked;
    if (bench_is(&s, "bed")) {          /* a loose lattice, shaken, dropped, at last with drag      */
        const double gap = BENCH_BED_SIDE/27;
        choice.force = drag_force;
        choice.force_user = &brake;
        for (i = 0; i < s.count; i++) {
            s.x[3*i] = (i%27 + 0.5)*gap + 0.05*r*(2*uniform() - 1);
            s.x[3*i + 1] = (i/27%27 + 0.5)*gap + 0.05*r*(2*uniform() - 1);
            s.x[3*i + 2] = r + (i/(27*27) + 0.05)*2.15*r + 0.05*r*(2*uniform() - 1);
            for (c = 0; c < 3; c++) s.v[3*i + c] = 0.2*(2*uniform() - 1);
        }
    } else if (bench_is(&s, "drum")) {  /* layers between the bars, then 0.302 s of turning         */
        const double dy = BENCH_DRUM_LENGTH/19, dx = 2.1*r;
        for (layer = 0; count < s.count && layer < 1000; layer++)
            for (x = -30; x <= 30; x++)
                for (y = 0; y < 19 && count < s.count; y++) {
                    const double px = x*dx, pz = -0.066 + r + layer*2.1*r;
                    if (sqrt(px*px + pz*pz) > 0.066 - r) continue;
                    s.x[3*count] = px + 0.03*r*(2*uniform() - 1);
                    s.x[3*count + 1] = (y + 0.5)*dy;
                    s.x[3*count + 2] = pz + 0.03*r*(2*uniform() - 1);
                    count++;
                }
        if (count < s.count) { study_fail("the drum holds %d beads, fewer than %d", count, s.count); return; }
    } else                              /* a lattice, and time to forget it                         */
        for (z = 0; z < 32; z++)
            for (y = 0; y < 32; y++)
                for (x = 0; x < 32; x++, count++) {
                    const double gap = BENCH_GAS_SIDE/32;
                    s.x[3*count] = (x + 0.5)*gap;
                    s.x[3*count + 1] = (y + 0.5)*gap;
                    s.x[3*count + 2] = (z + 0.5)*gap;
                    for (c = 0; c < 3; c++) mean[c] += s.v[3*count + c] = gaussian();
                }
    for (i = 0; i < s.count; i++) for (c = 0; c < 3; c++) s.v[3*i + c] -= mean[c]/s.count;
    world = bench_world_at(&s, &choice, BENCH_DRUM_ANGLE - BENCH_DRUM_SPEED*spin_up*180/3.14159265358979323846);
    if (!world) return;
    if (bench_is(&s, "bed")) {
        i = run(world, "bed falls", 32000);
        brake.rate = 100;
        i = i && run(world, "bed comes to rest", 12000);
    } else i = bench_is(&s, "drum") ? run(world, "drum turns", (int)(spin_up/s.dt + 0.5)) : run(world, "gas mixes", 12100);
    if (i) {
        const dem_totals t = dem_totals_get(world);
        bench_scene_take(&s, world);
        bench_scene_write(&s, study_path(bench_file(name)));
        study_result("kinetic", t.kinetic, "J");
        study_result("contacts_per_bead", 2.0*dem_counters_get(world).contacts/s.count, "");
        study_result_text("file", study_path(bench_file(name)), "");
    }
    dem_world_destroy(world);
    bench_scene_free(&s);
}

/* ---- for bench/peers.sh ---- */

/* The scene as LAMMPS and LIGGGHTS read it: name.data, and the drum's mesh. */
static void write_for_codes(const char *folder, const char *name) {
    const bench_scene s = bench_scene_read(data_folder, name);
    char path[512];
    FILE *file;
    int i;
    study_make_folder(folder);
    snprintf(path, sizeof path, "%s/%s.data", folder, name);
    file = fopen(path, "w");
    if (!file) { study_fail("cannot write %s: %s", path, strerror(errno)); return; }
    fprintf(file, "%s\n\n%d atoms\n1 atom types\n\n", name, s.count);
    if (bench_is(&s, "bed"))
        fprintf(file, "0 %.17g xlo xhi\n0 %.17g ylo yhi\n0 %.17g zlo zhi\n", BENCH_BED_SIDE, BENCH_BED_SIDE, BENCH_BED_HEIGHT);
    else if (bench_is(&s, "drum"))
        fprintf(file, "-0.08 0.08 xlo xhi\n0 %.17g ylo yhi\n-0.08 0.08 zlo zhi\n", BENCH_DRUM_LENGTH);
    else
        fprintf(file, "0 %.17g xlo xhi\n0 %.17g ylo yhi\n0 %.17g zlo zhi\n", BENCH_GAS_SIDE, BENCH_GAS_SIDE, BENCH_GAS_SIDE);
    fprintf(file, "\nAtoms\n\n");       /* id, type, diameter, density, place                        */
    for (i = 0; i < s.count; i++)
        fprintf(file, "%d 1 %.17g %.17g %.10g %.10g %.10g\n", i + 1, 2*s.radius, BENCH_DENSITY, s.x[3*i],
                s.x[3*i + 1], s.x[3*i + 2]);
    fprintf(file, "\nVelocities\n\n");  /* id, velocity, spin                                        */
    for (i = 0; i < s.count; i++)
        fprintf(file, "%d %.9g %.9g %.9g %.9g %.9g %.9g\n", i + 1, s.v[3*i], s.v[3*i + 1], s.v[3*i + 2],
                s.spin[3*i], s.spin[3*i + 1], s.spin[3*i + 2]);
    if (fclose(file)) study_fail("%s was not written in full: is the disk full?", path);
    snprintf(path, sizeof path, "%s/drum.stl", folder);
    if (bench_is(&s, "drum")) bench_drum_stl(path, BENCH_DRUM_ANGLE);
}

/* ---- steps whose instructions callgrind counts: it looks at counted_steps alone ---- */

DEMI_APART static int counted_steps(dem_world *world, int steps) { return dem_world_step(world, steps) == DEM_OK; }
/* `name`: a kind of walls (walls.plane), an effect, or "bed". Prints steps, bodies and contacts. */
static void count(const char *name) {
    enum { BEFORE = 20 };
    const int steps = steps_asked ? steps_asked : 10;
    const bench_choice none = BENCH_CHOICE;
    const bench_choice *choice = !strcmp(name, "bed") ? &none : 0;
    dem_world *world = 0;
    dem_counters c;
    size_t i;
    for (i = 0; i < sizeof walls_rows/sizeof *walls_rows; i++)
        if (!strncmp(name, "walls.", 6) && !strcmp(name + 6, walls_rows[i].name))
            world = walls_world(walls_rows[i].kind, walls_rows[i].n);
    for (i = 0; i < sizeof effect_rows/sizeof *effect_rows; i++)
        if (!strcmp(name, effect_rows[i].name) && !strcmp(effect_rows[i].scene, "bed")) choice = &effect_rows[i].with;
    if (choice) {
        bench_scene s = bench_scene_read(data_folder, "bed");
        world = bench_world(&s, choice);
        bench_scene_free(&s);
        if (world && dem_world_step(world, BEFORE) != DEM_OK) study_fail("%s: %s", name, dem_world_error_get(world));
    }
    if (!world) { study_fail("--count %s is neither bed, an effect on the bed nor walls.KIND", name); return; }
    if (!counted_steps(world, steps)) study_fail("%s: %s", name, dem_world_error_get(world));
    c = dem_counters_get(world);
    printf("counted %d steps, %d bodies, %d contacts\n", steps, !choice ? WALLS_BEADS : (int)dem_body_counts_get(world).present,
           c.contacts + c.wall_contacts);
    dem_world_destroy(world);
}

/* One line: seconds of the loop, contacts per bead and kinetic energy (J) at its end, bytes a bead. */
static void measure_raw(const bench_scene *s) {
    bench_choice choice = BENCH_CHOICE;
    dem_world *world;
    int r;
    choice.threads = threads_asked;
    choice.skin = skin_asked*s->radius;
    choice.cuts = cuts_asked;
    world = warm(s->name, s, &choice);
    for (r = 0; world && r < repeats(); r++) {
        const double seconds = loop(s->name, world, steps_of(s));
        const dem_counters c = dem_counters_get(world);
        if (seconds < 0) break;
        printf("raw %.6f %.5f %.6g %.0f\n", seconds, 2.0*c.contacts/s->count, dem_totals_get(world).kinetic,
               (double)c.memory/s->count);
    }
    if (world) dem_world_destroy(world);
}

int main(int argc, char **argv) {
    static const study_option table[] = {
        {"scene", STUDY_CHOICE, &scene_name, 0, 0, "all|bed|drum|gas|effects|sizes|walls", "what to measure"},
        {"effect", STUDY_TEXT, &effect_asked, 0, 0, "", "of the effects only those whose names contain this"},
        {"count", STUDY_TEXT, &counted, 0, 0, "", "take steps of this scene, for bench/instructions.sh: bed|EFFECT|walls.KIND"},
        {"steps", STUDY_INT, &steps_asked, 0, 1e8, "", "steps of one timed loop, 0: by scene"},
        {"repeat", STUDY_INT, &repeat_asked, 0, MOST_LOOPS, "", "timed loops, 0: 5, or 9 in full"},
        {"threads", STUDY_INT, &threads_asked, 1, 64, "", "threads to compare one thread with"},
        {"skin", STUDY_REAL, &skin_asked, -1, 10, "radii", "margin of the list, 0: the library's choice"},
        {"cuts", STUDY_INT, &cuts_asked, 0, 100, "", "with --raw: parts of each side of the drum's triangles (16: 61,440)"},
        {"quick", STUDY_FLAG, &quick, 0, 0, "", "short loops (the default)"},
        {"full", STUDY_FLAG, &full, 0, 0, "", "loops ten times as long, and more of them"},
        {"brief", STUDY_FLAG, &brief, 0, 0, "", "rates only"},
        {"cpu", STUDY_FLAG, &cpu, 0, 0, "", "processor time instead of wall time"},
        {"settle", STUDY_CHOICE, &settle, 0, 0, "bed|drum|gas", "make a start state anew"},
        {"codes", STUDY_TEXT, &codes, 0, 0, "", "write the scenes for other codes into this folder"},
        {"raw", STUDY_FLAG, &raw, 0, 0, "", "bare numbers, for bench/peers.sh"},
        {"data", STUDY_TEXT, &data_folder, 0, 0, "", "where the start states are"},
        {"out", STUDY_TEXT, &out, 0, 0, "", "folder of results"},
    };
    static const char *const names[3] = {"bed", "drum", "gas"};
    char folder[256];
    double load;
    int i;
    study_options(argc, argv, "How fast dem.h is, and what each choice costs.", table, (int)(sizeof table/sizeof *table));
    if (quick && full) { study_fail("--quick or --full, not both"); return 2; }
    if (raw) {
        for (i = 0; i < 3; i++)
            if (!strcmp(scene_name, names[i])) {
                bench_scene s = bench_scene_read(data_folder, names[i]);
                measure_raw(&s);
                bench_scene_free(&s);
            }
        return study.failures ? 1 : 0;
    }
    if (*counted) {
        count(counted);
        return study.failures ? 1 : 0;
    }
    if (*codes) {
        for (i = 0; i < 3; i++) write_for_codes(codes, names[i]);
        return study.failures ? 1 : 0;
    }
    snprintf(folder, sizeof folder, "build/out/%s", study.program);
    study_begin(*out ? out : folder);
    load = bench_load();
    bench_machine();
    if (cpu) study_result_text("clock", "processor time: not for threads, not for comparing with others", "");
    if (*settle) { settle_scene(settle); return study_end(); }
    for (i = 0; i < 3; i++)
        if (!strcmp(scene_name, names[i]) || !strcmp(scene_name, "all")) {
            bench_scene s = bench_scene_read(data_folder, names[i]);
            measure(&s);
            bench_scene_free(&s);
        }
    if (!strcmp(scene_name, "walls") || (!strcmp(scene_name, "all") && !brief)) walls();
    if (!strcmp(scene_name, "sizes") || (!strcmp(scene_name, "all") && !brief)) sizes();
    if (!strcmp(scene_name, "effects") || (!strcmp(scene_name, "all") && !brief)) effects(load);
    return study_end();
}
