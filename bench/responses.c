/* responses.c - springs beside impulses on the same scenes: time against error, and what solvers reach. MIT licence.

   build/responses          some minutes; results in build/out/responses: page.md for docs/impulses.md, responses.csv
                            for docs/data, figures
   build/responses --part pile|silo|hopper|drum|heap|sweeps|towers --seeds N

   pile      a column of discs falls apart (lesson 2): angle of repose
   silo      beads in a tube that rises (lesson 5): load of the floor over the weight of the beads
   hopper    discs run out of a slot (lesson 6): rate of discharge
   drum      discs in a rotating drum with lips (lesson 8), Froude number 0.05: torque
   heap      1,000, 10,000 and 100,000 spheres at rest, steps of 1 ms: sweeps, time of a step, of a contact and sweep
   sweeps    2,000 spheres: what is left after 30 to 1000 sweeps, cold, by each solver of convex cones
   towers    a tower of 20 cubes and a heap of 200, which should rest: error and time by solver and tolerance

   Errors are relative differences from the springs of the largest modulus (the reference). Their bars are standard
   errors over seeds. Every run uses one thread. */
#define DEM_IMPLEMENTATION
#include "dem.h"
#include "examples/study.h"
#include "bench/measure.h"

static FILE *page, *csv;
static int seeds = 3;
static const double g = 9.81, pi = 3.14159265358979;

/* One way to answer contacts: springs of a modulus (Pa), at the step chosen; or impulses at a step (s). */
typedef struct way { const char *name; double young, dt; } way;
enum { WAYS = 9 };
static const way ways[WAYS] = {
    {"springs, 2.5 GPa", 2.5e9, 0}, {"springs, 250 MPa", 2.5e8, 0}, {"springs, 25 MPa", 2.5e7, 0},
    {"springs, 2.5 MPa", 2.5e6, 0}, {"impulses, 0.1 ms", 0, 1e-4}, {"impulses, 0.2 ms", 0, 2e-4},
    {"impulses, 0.5 ms", 0, 5e-4}, {"impulses, 1 ms", 0, 1e-3}, {"impulses, 2 ms", 0, 2e-3}};

static dem_world_desc desc_of(const way *a) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.threads = 1;
    if (a->dt > 0) {
        desc.response = DEM_RESPONSE_IMPULSES;
        desc.dt = (dem_real)a->dt;
    }
    return desc;
}
static dem_material stuff_of(dem_world *world, const way *a, double rolling) {
    dem_material_desc stuff = DEM_MATERIAL_DESC;
    stuff.density = 2500;
    stuff.young = (dem_real)a->young;
    stuff.poisson = DEM_R(0.25);
    stuff.restitution = DEM_R(0.5);
    stuff.friction = DEM_R(0.4);
    stuff.rolling_friction = (dem_real)rolling;
    return dem_material_add(world, &stuff);
}
/* What a run has come to: the observable, and processor time of a simulated second; value < 0: it was refused. */
typedef struct told { double value, time; } told;
static told refused(dem_world *world) {
    const told none = {-1, 0};
    printf("  %s\n", dem_world_error_get(world));
    dem_world_destroy(world);
    return none;
}

/* ---- hopper ---- */

static told hopper_run(const way *a, int seed) {
    enum { COUNT = 480 };
    const double R = 2.5e-3, x = 0.045, deep = 5e-3;
    dem_world_desc desc = desc_of(a);
    dem_real corners[] = {DEM_R(-0.045), DEM_R(0.25), DEM_R(-0.045), 0, DEM_R(-0.01875), 0, DEM_R(0.01875), 0,
                                DEM_R(0.045), 0, DEM_R(0.045), DEM_R(0.25)};
    int32_t sides[] = {0, 1, 1, 2, 3, 4, 4, 5}, across[] = {2, 3};
    const dem_profile hopper = {6, 4, corners, sides}, lid = {6, 1, corners, across};
    dem_outlet_desc below;
    dem_outlet_state gone;
    dem_outlet out;
    dem_wall closed;
    dem_world *world;
    dem_material m;
    double mark[2] = {0, 0}, mass[2] = {0, 0}, begun, clock;
    told o;
    int i, stage = 0;
    desc.planar = 1;
    desc.thickness = (dem_real)deep;
    desc.gravity.y = (dem_real)-g;
    world = dem_world_create(&desc);
    m = stuff_of(world, a, 0);
    dem_wall_profile_add(world, m, &hopper, DEM_EDGE_RESOLVED);
    closed = dem_wall_profile_add(world, m, &lid, DEM_EDGE_RESOLVED);
    for (i = 0; i < 2; i++)
        dem_spheres_fill(world, m, (dem_real)((0.95 + 0.1*i)*R),
                         dem_region_make(dem_box_make((dem_real)-x, 0, 0, (dem_real)x, DEM_R(0.24), 0)), COUNT/2,
                         (uint64_t)(2*seed + i));
    memset(&below, 0, sizeof below);
    below.box = dem_box_make((dem_real)-x, DEM_R(-0.2), -1, (dem_real)x, DEM_R(-0.02), 1);
    out = dem_outlet_add(world, &below);
    clock = study_clock();
    if (dem_world_run(world, 0.3, 0, 0) != DEM_OK) return refused(world);
    dem_wall_remove(world, closed);
    begun = dem_world_time_get(world);
    while (stage < 2 && dem_world_time_get(world) < begun + 5) {
        if (dem_world_run(world, 0.01, 0, 0) != DEM_OK) return refused(world);
        dem_outlet_get(world, out, &gone);
        if ((int)gone.total >= COUNT*(stage ? 6 : 1)/10) {
            mark[stage] = dem_world_time_get(world);
            mass[stage++] = (double)gone.total_mass;
        }
    }
    o.value = (mass[1] - mass[0])/(mark[1] - mark[0]);
    o.time = (study_clock() - clock)/dem_world_time_get(world);
    dem_world_destroy(world);
    return o;
}

/* ---- drum ---- */

static told drum_run(const way *a, int seed) {
    enum { SIDES = 24 };
    const double R = 0.04, r = 1.5e-3, speed = sqrt(0.05*g/R);
    dem_real corners[4*SIDES];
    int32_t segments[4*SIDES];
    const dem_profile shell = {2*SIDES, 2*SIDES, corners, segments};
    dem_motion turning = DEM_MOTION;
    dem_world_desc desc = desc_of(a);
    dem_world *world;
    dem_material m;
    dem_wall drum;
    dem_wall_loads loads;
    double clock;
    told o;
    int i;
    for (i = 0; i < 2*SIDES; i++) {
        const double angle = pi*(i - i%2)/SIDES;
        corners[2*i] = (dem_real)((R - r*(i%2))*cos(angle));
        corners[2*i + 1] = (dem_real)((R - r*(i%2))*sin(angle));
        segments[2*i] = i - i%2;
        segments[2*i + 1] = i%2 ? i : (i + 2)%(2*SIDES);
    }
    desc.planar = 1;
    desc.thickness = DEM_R(3e-3);
    desc.gravity.y = (dem_real)-g;
    world = dem_world_create(&desc);
    m = stuff_of(world, a, 0.05);
    drum = dem_wall_profile_add(world, m, &shell, DEM_EDGE_RESOLVED);
    turning.kind = DEM_MOTION_ROTATING;
    turning.axis = dem_vec3_make(0, 0, 1);
    turning.speed = (dem_real)speed;
    dem_wall_motion_set(world, drum, &turning);
    dem_spheres_fill(world, m, (dem_real)r,
                     dem_region_make(dem_box_make(DEM_R(-0.03), DEM_R(-0.024), 0, DEM_R(0.03), DEM_R(0.024), 0)),
                     160, (uint64_t)seed + 1);
    clock = study_clock();
    if (dem_world_run(world, 0.6, 0, 0) != DEM_OK) return refused(world);
    dem_wall_loads_reset(world, drum);
    if (dem_world_run(world, 2, 0, 0) != DEM_OK) return refused(world);
    dem_wall_loads_get(world, drum, &loads);
    o.value = fabs(loads.torque_impulse/loads.time);
    o.time = (study_clock() - clock)/dem_world_time_get(world);
    dem_world_destroy(world);
    return o;
}

/* ---- pile, silo ---- */

static told pile_run(const way *a, int seed) {
    enum { COUNT = 220 };
    const double R = 2.5e-3, half = 0.02;
    const dem_real x = (dem_real)half, top = DEM_R(0.2);
    dem_real corners[8] = {-x, 0, -x, top, x, 0, x, top};
    int32_t sides[4] = {0, 1, 2, 3};
    const dem_profile walls = {4, 2, corners, sides};
    const dem_box all = {{0, 0, 0}, {0, 0, 0}};
    dem_world_desc desc = desc_of(a);
    dem_motion up = DEM_MOTION;
    dem_repose slope;
    dem_world *world;
    dem_material m;
    double clock;
    told o;
    int i;
    desc.planar = 1;
    desc.thickness = DEM_R(5e-3);
    desc.gravity.y = (dem_real)-g;
    world = dem_world_create(&desc);
    m = stuff_of(world, a, 0.2);
    dem_wall_plane_add(world, m, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 1, 0));
    up.kind = DEM_MOTION_TRANSLATING;
    up.velocity.y = DEM_R(0.2);
    up.start = 0.3;
    dem_wall_motion_set(world, dem_wall_profile_add(world, m, &walls, DEM_EDGE_RESOLVED), &up);
    for (i = 0; i < 2; i++)
        dem_spheres_fill(world, m, (dem_real)((0.9 + 0.2*i)*R),
                         dem_region_make(dem_box_make((dem_real)-half, 0, 0, (dem_real)half, DEM_R(0.19), 0)),
                         COUNT/2, (uint64_t)(2*seed + i));
    clock = study_clock();
    if (dem_world_run(world, 1.6, 0, 0) != DEM_OK || dem_repose_heap_get(world, all, &slope) != DEM_OK)
        return refused(world);
    o.value = slope.angle*180/pi;
    o.time = (study_clock() - clock)/dem_world_time_get(world);
    dem_world_destroy(world);
    return o;
}
/* What of the weight in a tube its floor bears, while the tube is drawn up slowly (lesson 5). */
static told silo_run(const way *a, int seed) {
    enum { COUNT = 300 };
    const double D = 24e-3;
    const dem_vec3 origin = {0, 0, 0}, up = {0, 0, 1};
    dem_world_desc desc = desc_of(a);
    dem_motion drawn = DEM_MOTION;
    dem_wall_loads below;
    dem_world *world;
    dem_material m;
    dem_wall floor, tube;
    double clock;
    told o;
    desc.gravity.z = (dem_real)-g;
    world = dem_world_create(&desc);
    m = stuff_of(world, a, 0);
    floor = dem_wall_plane_add(world, m, origin, up);
    tube = dem_wall_cylinder_add(world, m, origin, up, (dem_real)(D/2), 1);
    drawn.kind = DEM_MOTION_TRANSLATING;
    drawn.velocity.z = DEM_R(0.01);
    dem_wall_motion_set(world, tube, &drawn);
    dem_spheres_fill(world, m, DEM_R(2e-3),
                     dem_region_make(dem_box_make((dem_real)(-D/2), (dem_real)(-D/2), 0, (dem_real)(D/2), (dem_real)(D/2), DEM_R(0.096))),
                     COUNT, (uint64_t)seed + 1);
    clock = study_clock();
    if (dem_world_run(world, 0.4, 0, 0) != DEM_OK) return refused(world);
    dem_wall_loads_reset(world, floor);
    if (dem_world_run(world, 0.2, 0, 0) != DEM_OK) return refused(world);
    dem_wall_loads_get(world, floor, &below);
    o.value = -below.impulse[2]/below.time/(g*dem_totals_get(world).mass);
    o.time = (study_clock() - clock)/dem_world_time_get(world);
    dem_world_destroy(world);
    return o;
}

/* Results of the scenes, for the page: means, their bars (of the first of a scene, and with the first's of the others),
   processor time. A mean below 0: the run was refused. */
enum { SCENES = 4 };
static struct { const char *name, *what, *unit; double mean[WAYS], bar[WAYS], time[WAYS]; } results[SCENES];
static int result_count;

/* The means of the first way; then the differences from it, and the times: a row for each way, a column for each scene. */
static void page_results(void) {
    int i, k, which;
    if (!page || !result_count) return;
    fprintf(page, "\nThe reference, springs of 2.5 GPa:\n\n| scene | quantity | mean | unit | standard error, %% |\n"
            "|---|---|---|---|---|\n");
    for (k = 0; k < result_count; k++)
        fprintf(page, "| %s | %s | %.4g | %s | %.1f |\n", results[k].name, results[k].what, results[k].mean[0],
                results[k].unit, results[k].bar[0]);
    for (which = 0; which < 2; which++) {
        fprintf(page, which ? "\nProcessor time, s per simulated s:\n\n| contacts |"
                : "\nDifference from the reference, %% (\302\261 standard error of the difference):\n\n| contacts |");
        for (k = 0; k < result_count; k++)
            fprintf(page, which ? " %s |" : " %s: %s |", results[k].name, results[k].what);
        fprintf(page, "\n|---|");
        for (k = 0; k < result_count; k++) fprintf(page, "---|");
        for (i = which ? 0 : 1; i < WAYS; i++) {
            fprintf(page, "\n| %s |", ways[i].name);
            for (k = 0; k < result_count; k++)
                if (results[k].mean[i] < 0) fprintf(page, " stopped |");
                else if (which) fprintf(page, " %.3g |", results[k].time[i]);
                else fprintf(page, " %+.1f \302\261 %.1f |", 100*(results[k].mean[i]/results[k].mean[0] - 1), results[k].bar[i]);
        }
        fprintf(page, "\n");
    }
}
/* One way in one scene as a line of responses.csv; without numbers if it was refused. */
static void table_row(int scene, int i) {
    const double mean = results[scene].mean[i];
    if (!csv) return;
    fprintf(csv, "%s,%s,%s,%s,", results[scene].name, results[scene].what, results[scene].unit,
            ways[i].dt > 0 ? "impulses" : "springs");
    if (ways[i].dt > 0) fprintf(csv, ",%g,", ways[i].dt);
    else fprintf(csv, "%g,,", ways[i].young);
    if (mean < 0) fprintf(csv, ",,,\n");
    else fprintf(csv, "%.4g,%.1f,%.1f,%.3g\n", mean, 100*(mean/results[scene].mean[0] - 1), results[scene].bar[i],
                 results[scene].time[i]);
}
/* Every way, every seed: error against time. */
static void against(const char *name, const char *what, const char *unit, told (*run)(const way *a, int seed)) {
    double mean[WAYS], bar[WAYS], time[WAYS], x[2][WAYS], y[2][WAYS], ends[2] = {1e300, 0}, seeds_bar[2] = {0, 0};
    int i, k, n[2] = {0, 0};
    study_figure f;
    char label[96], file[32];
    const int at = result_count++;
    results[at].name = name;
    results[at].what = what;
    results[at].unit = unit;
    for (i = 0; i < WAYS; i++) {
        double sum = 0, squares = 0;
        int got = 0;
        time[i] = 0;
        for (k = 0; k < seeds; k++) {
            const told o = run(&ways[i], k);
            if (o.value < 0) continue;
            got++;
            sum += o.value;
            squares += o.value*o.value;
            time[i] += o.time;
        }
        if (!got) {
            results[at].mean[i] = mean[i] = -1;
            table_row(at, i);
            continue;
        }
        mean[i] = sum/got;
        bar[i] = got > 1 ? sqrt(fmax(0, squares/got - mean[i]*mean[i])/(got - 1)) : 0;
        time[i] /= got;
        snprintf(label, sizeof label, "%s.%d", name, i);
        printf("%s, %s: %s %.4g +- %.2g %s, %.3g s per simulated s\n", name, ways[i].name, what, mean[i], bar[i], unit,
               time[i]);
        results[at].mean[i] = mean[i];
        results[at].bar[i] = 100*hypot(bar[i], i ? bar[0] : 0)/mean[0];
        results[at].time[i] = time[i];
        table_row(at, i);
        if (!i) continue;
        k = ways[i].dt > 0;
        ends[0] = fmin(ends[0], time[i]);
        ends[1] = fmax(ends[1], time[i]);
        seeds_bar[0] += 1e4*(bar[i]*bar[i] + bar[0]*bar[0])/(mean[0]*mean[0]);
        x[k][n[k]] = time[i];
        y[k][n[k]++] = 100*fmax(fabs(mean[i]/mean[0] - 1), 1e-3);
    }
    memset(&f, 0, sizeof f);
    snprintf(label, sizeof label, "%s: %s, off springs of 2.5 GPa", name, what);
    f.title = label;
    f.x_label = "processor time of a simulated second [s]";
    f.y_label = "difference [%]";
    f.log_x = f.log_y = 1;
    study_curve(&f, "springs, softer and softer", STUDY_LINE, n[0], x[0], y[0]);
    study_curve(&f, "impulses, longer and longer steps", STUDY_DASHED, n[1], x[1], y[1]);
    snprintf(file, sizeof file, "%s.svg", name);
    seeds_bar[0] = seeds_bar[1] = sqrt(seeds_bar[0]/(n[0] + n[1]));
    study_curve(&f, "what so few seeds leave open (rms bar)", STUDY_LINE, 2, ends, seeds_bar);
    study_figure_write(&f, file);
}

/* ---- heaps ---- */

static dem_world *heap_make(dem_world_desc desc, int count) {
    const way stiff = {"", 0, 1e-3};
    const double side = 1.2e-3*cbrt((double)count);
    dem_world *world;
    dem_material m;
    desc.gravity.z = (dem_real)-g;
    desc.domain = dem_box_make(0, 0, 0, (dem_real)side, (dem_real)side, (dem_real)(10*side));
    desc.boundary[0] = desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
    desc.dt = DEM_R(4e-4);
    world = dem_world_create(&desc);
    m = stuff_of(world, &stiff, 0);
    dem_wall_plane_add(world, m, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
    dem_spheres_fill(world, m, DEM_R(6e-4),
                     dem_region_make(dem_box_make(0, 0, 0, (dem_real)side, (dem_real)side, (dem_real)(2.2*side))),
                     count, 1);
    return world;
}
static void heap_measure(int count) {
    const way rigid = {"", 0, 1e-3};
    dem_world *world = heap_make(desc_of(&rigid), count);
    const int steps = count > 10000 ? 20 : 100;
    double times[5], clock, swept = 0, all = 0, unsolved;
    int turn, k;
    if (dem_world_run(world, 0.6, 0, 0) != DEM_OK || dem_world_dt_set(world, DEM_R(1e-3)) != DEM_OK ||
        dem_world_step(world, 300) != DEM_OK) { refused(world); return; }
    unsolved = (double)dem_counters_get(world).unsolved;
    for (turn = 0; turn < 5; turn++) {
        clock = study_clock();
        for (k = 0; k < steps; k++) {
            if (dem_world_step(world, 1) != DEM_OK) { refused(world); return; }
            swept += dem_counters_get(world).sweeps;
        }
        times[turn] = (study_clock() - clock)/steps;
        all += times[turn]*steps;
    }
    snprintf(study.prefix, sizeof study.prefix, "heap%d.", count);
    study_result("step", 1e3*bench_median(times, 5), "ms");
    study_result("sweeps", swept/(5*steps), "");
    study_result("meetings", world->solver.count, "");
    study_result("unsolved", (double)dem_counters_get(world).unsolved - unsolved, "of these steps");
    study_result("seconds", 1e3*bench_median(times, 5), "s per simulated second");
    /* sweeps alone: as many as asked, of the same contacts */
    for (turn = 0; turn < 5; turn++) {
        demi_solved z;
        clock = study_clock();
        world->desc.tolerance = DEM_R(1e-30);
        z = demi_solve_seidel(world, 100);
        times[turn] = 1e9*(study_clock() - clock)/z.sweeps/world->solver.count;
    }
    study_result("contact_and_sweep", bench_median(times, 5), "ns");
    study.prefix[0] = 0;
    if (page) fprintf(page, "| %d | %d | %.1f | %.1f | %.1f |\n", count, world->solver.count, swept/(5*steps),
                      1e3*all/(5*steps), bench_median(times, 5));
    dem_world_destroy(world);
}
static void heap_part(void) {
    if (page) fprintf(page, "\nHeaps at rest, steps of 1 ms:\n\n| spheres | contacts within the range | sweeps in a step | time of "
                      "a step, ms | sweeps alone: time per sweep and contact, ns |\n|---|---|---|---|---|\n");
    heap_measure(1000);
    heap_measure(10000);
    heap_measure(100000);
}
/* States of a heap that has begun to lie, then one step of each solver from them, cold. */
static void sweeps_part(void) {
    static const int sweeps[4] = {30, 100, 300, 1000};
    const way rigid = {"", 0, 1e-3};
    dem_world *world = heap_make(desc_of(&rigid), 2000);
    int i, k, cone, count;
    dem_body_state *all;
    if (dem_world_run(world, 0.2, 0, 0) != DEM_OK) { refused(world); return; }
    count = dem_bodies_get(world).count;
    all = (dem_body_state *)malloc((size_t)count*sizeof *all);
    for (i = 0; i < count; i++) dem_body_get(world, dem_body_id_get(world, i), &all[i]);
    dem_world_destroy(world);
    for (cone = 0; cone < 2; cone++) {
        if (page && !cone) fprintf(page, "\n2,000 spheres that begin to settle, one step from a cold start: rms residual, m/s\n\n"
                                   "| solver | cone | after 30 sweeps | after 100 | after 300 | after 1000 |\n"
                                   "|---|---|---|---|---|---|\n");
        for (k = 0; k < DEMI_SOLVERS; k++) {
            if (page) fprintf(page, "| %s | %s |", demi_solvers[k].name, cone ? "convex" : "Coulomb");
            for (i = 0; i < 4; i++) {
                dem_world_desc desc = desc_of(&rigid);
                dem_counters c;
                char label[64];
                int q;
                desc.solver = (dem_solver)k;
                desc.cone = (dem_cone)cone;
                desc.sweeps = sweeps[i];
                desc.tolerance = DEM_R(1e-12);
                world = heap_make(desc, 2000);
                dem_world_dt_set(world, DEM_R(1e-3));
                for (q = 0; q < count; q++) dem_body_set(world, dem_body_id_get(world, q), &all[q]);
                if (demi_dt_settle(world) != DEM_OK || demi_refresh(world) != DEM_OK) { refused(world); return; }
                c = dem_counters_get(world);
                snprintf(label, sizeof label, "sweeps.%s.%s.%d", cone ? "convex" : "coulomb", demi_solvers[k].name,
                         sweeps[i]);
                study_result(label, (double)c.residual_rms, "m/s");
                if (page) fprintf(page, " %.2g |", (double)c.residual_rms);
                dem_world_destroy(world);
            }
            if (page) fprintf(page, "\n");
        }
    }
    free(all);
}

/* Cubes of 1 m on each other or dropped into a box of 5 x 5 m, steps of 10 ms. After 4 s the largest speed, which should
   be 0, over 2 s; and what a step takes. */
static void towers_measure(int heap, int solver, double tolerance) {
    enum { BEFORE = 400, STEPS = 200 };
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = DEM_MATERIAL_DESC;
    dem_world *world;
    dem_material rock;
    dem_shape cube;
    dem_real x[24];
    double sweeps = 0, left = 0, fastest = 0, clock;
    char label[80];
    int i, k;
    desc.gravity.z = (dem_real)-g;
    desc.response = DEM_RESPONSE_IMPULSES;
    desc.dt = DEM_R(0.01);
    desc.threads = 1;
    desc.solver = (dem_solver)solver;
    desc.tolerance = (dem_real)tolerance;
    world = dem_world_create(&desc);
    stuff.density = 2500;
    stuff.friction = DEM_R(0.5);
    stuff.restitution = 0;
    rock = dem_material_add(world, &stuff);
    dem_wall_plane_add(world, rock, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
    for (k = 0; k < 4 && heap; k++)
        dem_wall_plane_add(world, rock, dem_vec3_make(k & 1 ? 5 : 0, k & 1 ? 5 : 0, 0),
                           dem_vec3_make(DEM_R(0.0) + (k == 0) - (k == 1), DEM_R(0.0) + (k == 2) - (k == 3), 0));
    for (i = 0; i < 24; i++) x[i] = i/3 >> i%3 & 1 ? DEM_R(0.5) : DEM_R(-0.5);
    cube = dem_shape_polyhedron_add(world, 8, x);
    for (i = 0; i < (heap ? 200 : 20); i++) {
        const double side = 0.05*sin(12.9898*i);
        dem_body_add(world, rock, cube, heap ? dem_vec3_make((dem_real)(0.65 + i%4*1.23 + side),
                                                             (dem_real)(0.65 + i/4%4*1.23 - side),
                                                             (dem_real)(0.6 + i/16*1.1)) : dem_vec3_make(0, 0, i + DEM_R(0.5)),
                     dem_quat_make(1, 0, 0, 0));
    }
    if (dem_world_step(world, BEFORE) != DEM_OK) { refused(world); return; }
    clock = study_clock();
    for (k = 0; k < STEPS; k++) {
        dem_bodies all;
        dem_counters c;
        if (dem_world_step(world, 1) != DEM_OK) { refused(world); return; }
        all = dem_bodies_get(world);
        c = dem_counters_get(world);
        sweeps += c.sweeps;
        left = c.residual_rms > left ? (double)c.residual_rms : left;
        for (i = 0; i < all.count; i++) {
            const dem_real *v = all.velocities + 4*i;
            fastest = fmax(fastest, sqrt((double)(v[0]*v[0] + v[1]*v[1] + v[2]*v[2])));
        }
    }
    clock = (study_clock() - clock)/STEPS;
    snprintf(label, sizeof label, "towers.%s.%s.%g", heap ? "heap" : "tower", demi_solvers[solver].name, tolerance);
    study_result(label, fastest, "m/s");
    if (page) fprintf(page, "| %s | %s | %s%.0e | %.1e | %.1e | %.1f | %.2f |\n", heap ? "heap of 200" : "tower of 20",
                      demi_solvers[solver].name, tolerance > 0 ? "" : "default, rms ", tolerance > 0 ? tolerance : 5e-3, left,
                      fastest, sweeps/STEPS, 1e3*clock);
    dem_world_destroy(world);
}
static void towers_part(void) {
    static const double tolerance[3] = {0, 1e-3, 1e-5};
    int heap, k, i;
    if (page) fprintf(page, "\nCubes of 1 m that should rest, steps of 10 ms:\n\n| scene | solver | tolerance, m/s | largest rms "
                      "residual, m/s | largest speed, m/s | sweeps in a step | time of a step, ms |\n|---|---|---|---|---|---|---|\n");
    for (heap = 0; heap < 2; heap++)
        for (k = 0; k < DEMI_SOLVERS; k++)
            for (i = 0; i < 3; i++) towers_measure(heap, k, tolerance[i]);
}

int main(int argc, char **argv) {
    static const char *part = "all", *out = "build/out/responses";
    static const study_option table[] = {
        {"part", STUDY_TEXT, &part, 0, 0, "", "pile, silo, hopper, drum, heap, sweeps, towers or all"},
        {"seeds", STUDY_INT, &seeds, 1, 50, "", "runs of each"},
        {"out", STUDY_TEXT, &out, 0, 0, "", "folder of results"},
    };
    const double load = bench_load();
    const int all = 0 == (study_options(argc, argv, "Springs beside impulses.", table,
                                        (int)(sizeof table/sizeof *table)), strcmp(part, "all"));
    study_begin(out);
    bench_machine();
    page = bench_page_open();
    if (page) bench_page_machine(page, load);
    csv = bench_table_open("responses.csv", "scene,quantity,unit,response,young_Pa,dt_s,mean,difference_percent,"
                             "difference_error_percent,processor_s_per_simulated_s");
    if (all || !strcmp(part, "sweeps")) sweeps_part();
    if (all || !strcmp(part, "towers")) towers_part();
    if (all || !strcmp(part, "heap")) heap_part();
    if (all || !strcmp(part, "pile")) against("pile", "angle of repose", "degrees", pile_run);
    if (all || !strcmp(part, "silo")) against("silo", "load of the floor", "of the weight", silo_run);
    if (all || !strcmp(part, "hopper")) against("hopper", "discharge", "kg/s", hopper_run);
    if (all || !strcmp(part, "drum")) against("drum", "torque", "N m", drum_run);
    page_results();
    study_close(csv, "responses.csv");
    study_close(page, "page.md");
    return study_end();
}
