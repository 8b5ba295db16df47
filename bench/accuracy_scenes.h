/* accuracy_scenes.h - small scenes of build/accuracy, and how one is run with many choices and seeds. MIT licence.

   A choice is one setting of a scene; 0 stands for what the library chooses. A scene is a function that runs it once
   and answers what was observed and how much processor time that took. Of several choices the first is the reference
   (shorter steps, twice as many seeds), the second the library's own, whose cost is 1. Costs are compared within a
   turn, in which every choice runs once: what disturbs a turn disturbs all.

   Needs dem.h, examples/study.h, bench/measure.h and bench/accuracy_points.h before it. */
#ifndef ACCURACY_SCENES_H
#define ACCURACY_SCENES_H

#define ACCURACY_PI 3.14159265358979323846
#define ACCURACY_YOUNG 1e9          /* Pa: of a true grain; as M1 of Dosta et al. 2024                          */
enum { SCENE_VALUES = 4, SCENE_SEEDS = 16, SCENE_CHOICES = 20 };

typedef struct choice {
    const char *series, *label;     /* series null: a reference, not drawn                                   */
    double step;                    /* time step over that of the library                                    */
    double soften;                  /* E over that of a true grain; 0: a hundredth                           */
    double skin;                    /* in radii; < 0: none                                                   */
    dem_integrator integrator;
    dem_normal_law normal;
    dem_tangent_law tangent;
    dem_rolling_law rolling;
    dem_slider slider;
    dem_search search;
    dem_overlap overlap;
    int kind;                       /* what only one scene knows                                             */
} choice;
typedef struct outcome {
    double value[SCENE_VALUES], seconds, overlap; /* seconds of processor time; overlap over the radius      */
    int ok;                         /* 0: the run was stopped                                                */
} outcome;
typedef outcome (*scene_fn)(const choice *c, int seed);

static int quick;                   /* --quick: shorter runs, two seeds                                      */
static double cpu_clock(void) { return (double)clock()/CLOCKS_PER_SEC; }

/* ---- many runs ---- */

static int scene_seeds(int wanted) { return quick ? 2 : wanted; }
static void scene_measure(const char *name, scene_fn scene, const choice *c, int count, int seeds, outcome *out) {
    int i, seed, done = 0;
    for (seed = 0; seed < 2*seeds; seed++)
        for (i = 0; i < (seed < seeds ? count : 1); i++) {
            study_progress(name, (double)done++/(seeds*(count + 1)), 0);
            out[i*SCENE_SEEDS + seed] = scene(&c[i], seed + 1);
        }
    study_progress(name, 1, 0);
}
static double scene_mean(const outcome *out, int seeds, int what, double *error) { /* standard error */
    double sum = 0, square = 0;
    int i;
    for (i = 0; i < seeds; i++) {
        if (!out[i].ok) { *error = (double)NAN; return (double)NAN; }
        sum += out[i].value[what];
        square += out[i].value[what]*out[i].value[what];
    }
    sum /= seeds;
    *error = seeds > 1 ? sqrt(fmax(square/seeds - sum*sum, 0)/(seeds - 1)) : 0;
    return sum;
}
static double scene_cost(const outcome *out, const outcome *unit, int seeds) { /* of the same turns */
    double a[SCENE_SEEDS], b[SCENE_SEEDS];
    int i;
    for (i = 0; i < seeds; i++) { a[i] = out[i].seconds; b[i] = unit[i].seconds; }
    return bench_median_ratio(a, b, seeds);
}
/* Points of a diagram: |mean - reference| over the reference. */
static void scene_points(points *p, const choice *c, int count, int seeds, const outcome *out, int what) {
    char text[160], name[128];
    double mean[SCENE_CHOICES], bar[SCENE_CHOICES], known[SCENE_CHOICES], usual;
    int i, n = 0;
    for (i = 0; i < count; i++) {
        mean[i] = scene_mean(out + i*SCENE_SEEDS, i ? seeds : 2*seeds, what, &bar[i]);
        if (i && bar[i] == bar[i]) known[n++] = bar[i];
    }
    usual = n ? bench_median(known, n) : 0;  /* few seeds may agree by chance: no bar is shorter than usual  */
    for (i = 0; i < count; i++) {
        bar[i] = fmax(bar[i], i ? usual : usual/sqrt(2.0));
        snprintf(name, sizeof name, "%s.value.%s.%s", p->name, c[i].series ? c[i].series : "reference", c[i].label);
        points_word(name);
        snprintf(text, sizeof text, "%.5g +- %.2g", mean[i], bar[i]);
        study_result_text(name, mean[i] == mean[i] ? text : "none: a run was stopped", "");
        if (i) points_add(p, c[i].series, c[i].label, scene_cost(out + i*SCENE_SEEDS, out + SCENE_SEEDS, seeds),
                          mean[i]/mean[0] - 1, hypot(bar[i], bar[0])/fabs(mean[0]));
    }
    snprintf(text, sizeof text, "reference, %s", c[0].label);
    points_number(p, text, mean[0], bar[0], p->unit, 2*seeds);
}

/* ---- worlds ---- */

typedef struct built { dem_world *world; dem_material stuff; dem_wall wall, gate; dem_outlet outlet; } built;
typedef int (*build_fn)(built *b, const choice *c, int seed);

static dem_world_desc scene_desc(const choice *c, double radius, double speed) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.threads = 1;
    desc.allow_large_dt = 1;
    desc.impact_speed = (dem_real)speed;
    desc.integrator = c->integrator;
    desc.normal_law = c->normal;
    desc.tangent_law = c->tangent;
    desc.rolling_law = c->rolling;
    desc.slider = c->slider;
    desc.search = c->search;
    desc.skin = (dem_real)(c->skin*radius);
    desc.ellipsoid_overlap = c->overlap;
    return desc;
}
static dem_world_desc scene_discs(const choice *c, double radius, double speed) {
    dem_world_desc desc = scene_desc(c, radius, speed);
    desc.planar = 1;
    desc.thickness = (dem_real)(4*radius/3); /* as heavy as balls */
    desc.gravity.y = DEM_R(-9.81);
    return desc;
}
static double scene_young(const choice *c) { return ACCURACY_YOUNG*(c->soften > 0 ? c->soften : 0.01); }
static dem_material scene_material(dem_world *world, const choice *c, double restitution, double friction,
                                   double rolling) {
    dem_material_desc m = DEM_MATERIAL_DESC;
    m.density = 2500;
    m.young = (dem_real)scene_young(c);
    m.poisson = DEM_R(0.2);
    m.restitution = (dem_real)restitution;
    m.friction = (dem_real)friction;
    m.rolling_friction = (dem_real)rolling;
    return dem_material_add(world, &m);
}
/* Built twice: to hear the library's time step, and with the choice's. */
static int scene_build(built *b, dem_world_desc desc, const choice *c, build_fn build, int seed) {
    dem_advice advice;
    int pass, ok = 1;
    desc.dt = 0;
    for (pass = 0; pass < 2 && ok; pass++) {
        memset(b, 0, sizeof *b);
        b->world = dem_world_create(&desc);
        if (!b->world) { study_fail("%s", dem_world_create_error_get(&desc)); return 0; }
        ok = build(b, c, seed) && dem_step_advice_get(b->world, &advice) == DEM_OK;
        if (!ok) study_fail("a scene was refused: %s", dem_world_error_get(b->world));
        if (!pass || !ok) dem_world_destroy(b->world);
        if (ok) desc.dt = advice.dt*(dem_real)(c->step > 0 ? c->step : 1);
    }
    return ok;
}
/* Runs on, and adds the processor time it took. */
static int scene_run(built *b, double seconds, outcome *o) {
    const double begun = cpu_clock();
    o->ok = dem_world_run(b->world, seconds, 0, 0) == DEM_OK;
    o->seconds += cpu_clock() - begun;
    if (!o->ok) (void)dem_world_error_get(b->world); /* too long a step breaks the run: a point without an error */
    return o->ok;
}
static void scene_end(built *b, outcome *o) {
    o->overlap = (double)dem_counters_get(b->world).overlap_max;
    dem_world_destroy(b->world);
}
/* Three sizes, a fifth apart, so that discs do not form a lattice. share of the count is filled of each. */
static int scene_fill(built *b, double radius, const dem_region *region, int count, int seed) {
    int k, done = 0;
    for (k = 2; k >= 0; k--)
        done += dem_spheres_fill(b->world, b->stuff, (dem_real)(radius*(0.8 + 0.2*k)), *region, count/3,
                                 (uint64_t)(100*seed + k));
    return done == 3*(count/3);
}
static dem_region scene_box(double x0, double y0, double x1, double y1) {
    dem_region region;
    memset(&region, 0, sizeof region);
    region.box = dem_box_make((dem_real)x0, (dem_real)y0, 0, (dem_real)x1, (dem_real)y1, 0);
    return region;
}
/* A line of segments through count points (x, y); closed: back to the first. */
static dem_wall scene_line(built *b, const double *xy, int count, int closed) {
    dem_real v[2*400];
    int32_t segment[2*400];
    dem_profile profile;
    int i;
    for (i = 0; i < 2*count; i++) v[i] = (dem_real)xy[i];
    for (i = 0; i < count; i++) { segment[2*i] = i; segment[2*i + 1] = (i + 1)%count; }
    profile.vertex_count = count;
    profile.segment_count = closed ? count : count - 1;
    profile.vertices = v;
    profile.segments = segment;
    return dem_wall_profile_add(b->world, b->stuff, &profile, DEM_EDGE_RESOLVED);
}
static dem_wall scene_side(built *b, double x, double y, double nx, double ny) {
    return dem_wall_plane_add(b->world, b->stuff, dem_vec3_make((dem_real)x, (dem_real)y, 0),
                         dem_vec3_make((dem_real)nx, (dem_real)ny, 0));
}
/* Below y grains are taken out. */
static int scene_drain(built *b, double y) {
    dem_outlet_desc outlet;
    memset(&outlet, 0, sizeof outlet);
    outlet.box = dem_box_make(-10, -10, -10, 10, (dem_real)y, 10);
    b->outlet = dem_outlet_add(b->world, &outlet);
    return b->outlet.id != 0;
}

/* ---- hopper: a flat bottom with a slot of eight diameters ---- */

#define SCENE_RADIUS 5e-3           /* m, of the middle size                                                 */
#define HOPPER_HALF 0.09            /* m                                                                     */
#define HOPPER_SLOT 0.04            /* m, half of it                                                         */
enum { HOPPER_GRAINS = 480 };
static int hopper_build(built *b, const choice *c, int seed) {
    static const double left[] = {-0.2, 0, -HOPPER_SLOT, 0}, right[] = {HOPPER_SLOT, 0, 0.2, 0};
    static const double plug[] = {-HOPPER_SLOT, 0, HOPPER_SLOT, 0};
    const dem_region region = scene_box(-HOPPER_HALF, 0, HOPPER_HALF, 0.5);
    b->stuff = scene_material(b->world, c, 0.5, 0.3, 0);
    return b->stuff.id && scene_side(b, -HOPPER_HALF, 0, 1, 0).id && scene_side(b, HOPPER_HALF, 0, -1, 0).id &&
           scene_line(b, left, 2, 0).id && scene_line(b, right, 2, 0).id && (b->gate = scene_line(b, plug, 2, 0)).id &&
           scene_drain(b, -0.1) && scene_fill(b, SCENE_RADIUS, &region, HOPPER_GRAINS, seed);
}
static int hopper_out(const built *b) { /* grains whose centre is below the floor, those taken out included */
    const dem_bodies bodies = dem_bodies_get(b->world);
    int i, inside = 0;
    for (i = 0; i < bodies.count; i++) inside += bodies.positions[4*i + 1] > 0;
    return HOPPER_GRAINS - inside;
}
/* value: grains a second, while the share that is out rises from .15 to .8. */
static outcome scene_hopper(const choice *c, int seed) {
    const double each = 2e-3;
    outcome o = {{0}, 0, 0, 1};
    built b;
    double time = 0, from = 0, to = 0, before = 0, now;
    if (!scene_build(&b, scene_discs(c, SCENE_RADIUS, 1), c, hopper_build, seed)) return o;
    scene_run(&b, 0.4, &o);
    o.ok = o.ok && dem_wall_remove(b.world, b.gate) == DEM_OK;
    while (o.ok && to <= 0 && time < 6) {
        if (!scene_run(&b, each, &o)) break;
        time += each;
        now = (double)hopper_out(&b)/HOPPER_GRAINS;
        if (now >= 0.15 && before < 0.15) from = time - each*(now - 0.15)/(now - before);
        if (now >= 0.8 && before < 0.8) to = time - each*(now - 0.8)/(now - before);
        before = now;
    }
    o.ok = o.ok && to > 0;
    o.value[0] = o.ok ? 0.65*HOPPER_GRAINS/(to - from) : 0;
    scene_end(&b, &o);
    return o;
}

/* ---- pile: what stays on a shelf when its front is taken away ---- */

#define PILE_WIDTH 0.25             /* m                                                                     */
enum { PILE_GRAINS = 450 };
static int pile_build(built *b, const choice *c, int seed) {
    static const double floor_line[] = {-0.1, 0, PILE_WIDTH, 0}, front[] = {PILE_WIDTH, 0, PILE_WIDTH, 0.8};
    const dem_region region = scene_box(0, 0, PILE_WIDTH, 0.36);
    b->stuff = scene_material(b->world, c, 0.5, 0.5, 0.1);
    return b->stuff.id && scene_side(b, 0, 0, 1, 0).id && scene_line(b, floor_line, 2, 0).id &&
           (b->gate = scene_line(b, front, 2, 0)).id && scene_drain(b, -0.1) &&
           scene_fill(b, SCENE_RADIUS, &region, PILE_GRAINS, seed);
}
/* value: slope, degrees, of the triangle with the same centre of mass; kinetic energy over m g d of a grain. */
static outcome scene_pile(const choice *c, int seed) {
    outcome o = {{0}, 0, 0, 1};
    built b;
    dem_bodies bodies;
    double x = 0, y = 0, m = 0;
    dem_totals totals;
    int i;
    if (!scene_build(&b, scene_discs(c, SCENE_RADIUS, 1), c, pile_build, seed)) return o;
    scene_run(&b, 0.4, &o);
    o.ok = o.ok && dem_wall_remove(b.world, b.gate) == DEM_OK && scene_run(&b, 1.2, &o);
    bodies = dem_bodies_get(b.world);
    for (i = 0; i < bodies.count; i++) {
        const double mass = (double)bodies.masses[i];
        if (bodies.positions[4*i + 1] < 0) continue;
        x += mass*(double)bodies.positions[4*i];
        y += mass*(double)bodies.positions[4*i + 1];
        m += mass;
    }
    totals = dem_totals_get(b.world);
    o.ok = o.ok && m > 0;
    o.value[0] = o.ok ? atan2(y, x)*180/ACCURACY_PI : 0;
    o.value[1] = (totals.kinetic + totals.rotational)/(totals.mass*9.81*2*SCENE_RADIUS);
    scene_end(&b, &o);
    return o;
}

/* ---- drum: a turning cylinder with bars ---- */

#define DRUM_RADIUS 0.1             /* m                                                                     */
typedef struct drum_kind {
    int bars, small, large;         /* how many; of the two sizes; small = 0: three sizes, large in all      */
    double height, speed;           /* m, of the bars; rad/s                                                 */
    double radius, settle, time;    /* m, of the middle or large size; s                                     */
    double friction, rolling;
} drum_kind;
static const drum_kind *drum_now;        /* the one being built                                                   */
static int drum_build(built *b, const choice *c, int seed) {
    const drum_kind *d = drum_now;
    const int arc = 48/d->bars + 1, count = d->bars*(arc + 2);
    const double wide = 0.006/DRUM_RADIUS, inner = DRUM_RADIUS - d->height;
    dem_region region = scene_box(-inner, -inner, inner, inner);
    dem_motion turning = DEM_MOTION;
    double xy[2*400];
    int k, i, n = 0, done;
    for (k = 0; k < d->bars; k++) {
        const double from = 2*ACCURACY_PI*k/d->bars, to = 2*ACCURACY_PI*(k + 1)/d->bars;
        for (i = 0; i < arc + 2; i++) { /* a bar's two upper corners, then along the shell to the next one   */
            const double at = i < 2 ? from + i*wide : from + wide + (to - from - wide)*(i - 2)/(arc - 1);
            const double r = i < 2 ? inner : DRUM_RADIUS;
            xy[n++] = r*cos(at);
            xy[n++] = r*sin(at);
        }
    }
    b->stuff = scene_material(b->world, c, 0.5, d->friction, d->rolling);
    turning.kind = DEM_MOTION_ROTATING;
    turning.axis = dem_vec3_make(0, 0, 1);
    turning.speed = (dem_real)d->speed;
    region.cylinder = 'z';
    if (!b->stuff.id || !(b->wall = scene_line(b, xy, count, 1)).id ||
        dem_wall_motion_set(b->world, b->wall, &turning) != DEM_OK) return 0;
    if (!d->small) return scene_fill(b, d->radius, &region, d->large, seed);
    done = dem_spheres_fill(b->world, b->stuff, (dem_real)d->radius, region, d->large, (uint64_t)(100*seed));
    done += dem_spheres_fill(b->world, b->stuff, (dem_real)(d->radius/2), region, d->small,
                             (uint64_t)(100*seed + 1));
    return done == d->small + d->large;
}
/* How near small grains are to the middle of the charge, over large ones: 1 mixed, 0 all at one place. */
static double drum_core(const dem_bodies *b, double radius, double cx, double cy) {
    double sum[2] = {0, 0};
    int i, count[2] = {0, 0};
    for (i = 0; i < b->count; i++) {
        const int large = (double)b->positions[4*i + 3] > 0.75*radius;
        sum[large] += hypot((double)b->positions[4*i] - cx, (double)b->positions[4*i + 1] - cy);
        count[large]++;
    }
    return sum[0]/count[0]/(sum[1]/count[1]);
}
/* value: mean power, W; angle of the charge's centre of mass from straight down, degrees; how far sizes are apart. */
static outcome drum_run(const drum_kind *d, const choice *c, int seed) {
    outcome o = {{0}, 0, 0, 1};
    const int samples = 300;
    dem_wall_loads loads;
    built b;
    double x = 0, y = 0, core = 0;
    int i;
    drum_now = d;
    if (!scene_build(&b, scene_discs(c, d->radius, fmax(d->speed*DRUM_RADIUS, 0.5)), c, drum_build, seed)) return o;
    scene_run(&b, d->settle, &o);
    o.ok = o.ok && dem_wall_loads_reset(b.world, b.wall) == DEM_OK;
    for (i = 0; i < samples && o.ok && scene_run(&b, d->time/samples, &o); i++) {
        const dem_totals t = dem_totals_get(b.world);
        const dem_bodies bodies = dem_bodies_get(b.world);
        x += t.centre[0];
        y += t.centre[1];
        if (d->small) core += drum_core(&bodies, d->radius, t.centre[0], t.centre[1])/samples;
    }
    o.ok = o.ok && dem_wall_loads_get(b.world, b.wall, &loads) == DEM_OK;
    if (o.ok) o.value[0] = loads.work/loads.time;
    o.value[1] = atan2(x, -y)*180/ACCURACY_PI;
    o.value[2] = core;
    scene_end(&b, &o);
    return o;
}
static outcome scene_mill(const choice *c, int seed) {
    static const drum_kind mill = {8, 0, 210, 0.012, 6.93, 4e-3, 0.8, 2.4, 0.5, 0}; /* 70 % of critical               */
    return drum_run(&mill, c, seed);
}
static outcome scene_slow(const choice *c, int seed) {
    static const drum_kind slow = {24, 0, 210, 0.004, 1.5, 4e-3, 0.8, 2.4, 0.5, 0.1};
    return drum_run(&slow, c, seed);
}
static outcome scene_sizes(const choice *c, int seed) {
    static const drum_kind sizes = {24, 180, 45, 0.004, 1.5, 6e-3, 2.5, 2.5, 0.5, 0};
    return drum_run(&sizes, c, seed);
}
#endif /* ACCURACY_SCENES_H */
