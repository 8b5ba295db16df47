/* accuracy_beds.h - many bodies: an elastic gas, a settled bed, a gas of ellipsoids, clusters, the search. MIT licence.
   Needs all that bench/accuracy.c includes before it. */
#ifndef ACCURACY_BEDS_H
#define ACCURACY_BEDS_H

/* Points whose value is an error by itself; mean over seeds. chance: 1: with a bar. */
static void scene_errors(points *p, const choice *c, int count, int seeds, const outcome *out, int what, int chance) {
    double bar;
    int i;
    for (i = 1; i < count; i++) {
        const double mean = scene_mean(out + i*SCENE_SEEDS, seeds, what, &bar);
        points_add(p, c[i].series, c[i].label, scene_cost(out + i*SCENE_SEEDS, out + SCENE_SEEDS, seeds), mean,
                   chance ? bar : 0);
    }
}

/* ---- an elastic gas: 400 smooth spheres, 10 % of a periodic cube ---- */

enum { GAS_GRAINS = 400, GAS_ELLIPSOIDS = 120 };
#define GAS_SOLID 0.1
static double gas_random(uint64_t *state) {  /* -1 .. 1; from one 64-bit number to the next [Knuth's MMIX] */
    *state = *state*UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*state >> 11)/4503599627370496.0 - 1;
}
static int gas_build(built *b, const choice *c, int seed) { /* velocities uniform in a cube, mean square 1     */
    const dem_world_desc desc = dem_world_desc_get(b->world);
    uint64_t state = (uint64_t)seed*977;
    int i, ok;
    b->stuff = scene_material(b->world, c, 1, 0, 0);
    ok = b->stuff.id && dem_spheres_fill(b->world, b->stuff, DEM_R(SCENE_RADIUS), dem_region_make(desc.domain),
                                         GAS_GRAINS, (uint64_t)seed) == GAS_GRAINS;
    for (i = 0; i < GAS_GRAINS && ok; i++) {
        const dem_body body = dem_body_id_get(b->world, i);
        dem_body_state s;
        ok = dem_body_get(b->world, body, &s) == DEM_OK;
        s.velocity = dem_vec3_make((dem_real)gas_random(&state), (dem_real)gas_random(&state),
                                   (dem_real)gas_random(&state));
        ok = ok && dem_body_set(b->world, body, &s) == DEM_OK;
    }
    return ok;
}
/* Sum over contacts of force times distance, J. */
static double gas_virial(const dem_world *world, dem_real radius) {
    static dem_contact_info contact[GAS_GRAINS];
    const int count = dem_contacts_get(world, contact, GAS_GRAINS);
    double sum = 0;
    int i;
    for (i = 0; i < count && i < GAS_GRAINS; i++)
        sum += -(double)(contact[i].force.x*contact[i].normal.x + contact[i].force.y*contact[i].normal.y +
                         contact[i].force.z*contact[i].normal.z)*(double)(2*radius - contact[i].overlap);
    return sum;
}
static dem_world_desc gas_desc(const choice *c, double volume) {
    dem_world_desc desc = scene_desc(c, SCENE_RADIUS, 1.5);
    const dem_real side = (dem_real)cbrt(volume/GAS_SOLID);
    desc.domain = dem_box_make(0, 0, 0, side, side, side);
    desc.boundary[0] = desc.boundary[1] = desc.boundary[2] = DEM_BOUNDARY_PERIODIC;
    desc.ledger = 1;
    return desc;
}
/* value: largest departure of the energy from that at first; pressure over that of an ideal gas. */
static outcome scene_gas(const choice *c, int seed) {
    const double time = quick ? 0.1 : 0.4;
    outcome o = {{0}, 0, 0, 1};
    built b;
    double first, virial = 0, energy = 0, dt;
    int k, samples, each;
    if (!scene_build(&b, gas_desc(c, GAS_GRAINS*4*ACCURACY_PI/3*pow(SCENE_RADIUS, 3)), c, gas_build, seed)) return o;
    first = kinetic(b.world);
    o.ok = dem_world_step(b.world, 1) == DEM_OK;
    dt = (double)dem_counters_get(b.world).dt;
    each = (int)(10/(c->step > 0 ? c->step : 1));    /* steps, a fifth of a contact                          */
    each = each > 1 ? each : 1;
    samples = (int)(time/(each*dt));
    for (k = 0; k < samples && o.ok; k++) {
        const double begun = cpu_clock();
        dem_ledger l;
        o.ok = dem_world_step(b.world, each) == DEM_OK;
        o.seconds += cpu_clock() - begun;
        l = dem_ledger_get(b.world);
        o.value[0] = fmax(o.value[0], fabs((l.kinetic + l.elastic)/first - 1));
        virial += gas_virial(b.world, DEM_R(SCENE_RADIUS));
        energy += l.kinetic;
    }
    o.value[1] = 1 + virial/(2*energy);
    scene_end(&b, &o);
    return o;
}
static const choice gas_choices[] = {
    {.label = "t_c/200", .step = 0.25, .soften = 1}, {"velocity Verlet", "t_c/50", .soften = 1},
    {"velocity Verlet", "t_c/100", .step = 0.5, .soften = 1}, {"velocity Verlet", "t_c/20", .step = 2.5, .soften = 1},
    {"velocity Verlet", "t_c/10", .step = 5, .soften = 1}, {"velocity Verlet", "t_c/5", .step = 10, .soften = 1},
    {"leapfrog", "t_c/50", .integrator = DEM_INTEGRATOR_LEAPFROG, .soften = 1},
    {"position Verlet", "t_c/50", .integrator = DEM_INTEGRATOR_POSITION_VERLET, .soften = 1},
    {"symplectic Euler", "t_c/50", .integrator = DEM_INTEGRATOR_SYMPLECTIC_EULER, .soften = 1},
    {"symplectic Euler", "t_c/20", .integrator = DEM_INTEGRATOR_SYMPLECTIC_EULER, .step = 2.5, .soften = 1},
    {"forward Euler", "t_c/50", .integrator = DEM_INTEGRATOR_FORWARD_EULER, .soften = 1},
    {"forward Euler", "t_c/100", .integrator = DEM_INTEGRATOR_FORWARD_EULER, .step = 0.5, .soften = 1}};
enum { GAS_CHOICES = (int)(sizeof gas_choices/sizeof *gas_choices), GAS_SEEDS = 4 };
static outcome gas_out[GAS_CHOICES*SCENE_SEEDS];
static int gas_done;
static int gas_all(void) {
    const int seeds = scene_seeds(GAS_SEEDS);
    if (!gas_done++) scene_measure("gas", scene_gas, gas_choices, GAS_CHOICES, seeds, gas_out);
    return seeds;
}
static void fill_gas_energy(points *p) {
    const int seeds = gas_all();
    scene_errors(p, gas_choices, GAS_CHOICES, seeds, gas_out, 0, 0);
    variant_scene(p, gas_choices, GAS_CHOICES, seeds, gas_out, 0, 0);
}
static void fill_gas_pressure(points *p) {
    const double g = (1 - GAS_SOLID/2)/pow(1 - GAS_SOLID, 3), enskog = 1 + 4*GAS_SOLID*g;
    const int seeds = gas_all();
    double bar;
    scene_points(p, gas_choices, GAS_CHOICES, seeds, gas_out, 1);
    points_number(p, "hard spheres (Carnahan, Starling)", enskog, 0, p->unit, 0);
    p->mark = fabs(scene_mean(gas_out, 2*seeds, 1, &bar)/enskog - 1);
    p->mark_name = "converged against hard spheres (Carnahan, Starling)";
}

/* ---- a settled bed: 400 balls in a periodic box of six diameters ---- */

enum { BED_GRAINS = 399 };
#define BED_SIDE 0.06
static int bed_build(built *b, const choice *c, int seed) {
    dem_region region;
    memset(&region, 0, sizeof region);
    region.box = dem_box_make(0, 0, 0, DEM_R(BED_SIDE), DEM_R(BED_SIDE), DEM_R(0.3));
    b->stuff = scene_material(b->world, c, 0.5, 0.5, 0);
    b->wall = dem_wall_plane_add(b->world, b->stuff, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
    return b->stuff.id && b->wall.id && scene_fill(b, SCENE_RADIUS, &region, BED_GRAINS, seed);
}
/* value: |force on the floor over weight - 1|, mean of .1 s; solid fraction; kinetic energy over m g d, a grain. */
static outcome scene_bed(const choice *c, int seed) {
    outcome o = {{0}, 0, 0, 1};
    dem_world_desc desc = scene_desc(c, SCENE_RADIUS, 1);
    dem_wall_loads loads;
    dem_totals t;
    built b;
    desc.gravity.z = DEM_R(-9.81);
    desc.domain = dem_box_make(0, 0, 0, DEM_R(BED_SIDE), DEM_R(BED_SIDE), 1);
    desc.boundary[0] = desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
    if (!scene_build(&b, desc, c, bed_build, seed)) return o;
    scene_run(&b, quick ? 0.4 : 0.8, &o);
    o.ok = o.ok && dem_wall_loads_reset(b.world, b.wall) == DEM_OK && scene_run(&b, 0.1, &o) &&
           dem_wall_loads_get(b.world, b.wall, &loads) == DEM_OK;
    t = dem_totals_get(b.world);
    if (o.ok) o.value[0] = fabs(fabs(loads.impulse[2])/loads.time/(t.mass*9.81) - 1);
    o.value[1] = t.mass/2500/(BED_SIDE*BED_SIDE*2*t.centre[2]);
    o.value[2] = (t.kinetic + t.rotational)/(t.mass*9.81*2*SCENE_RADIUS);
    scene_end(&b, &o);
    return o;
}
static const choice bed_choices[] = {
    {.label = "t_c/100", .step = 0.5}, {"default settings", "t_c/50", .step = 1},
    {"default settings", "t_c/20", .step = 2.5}, {"default settings", "t_c/10", .step = 5},
    {"linear", "t_c/50", .normal = DEM_NORMAL_LINEAR}, {"linear", "t_c/20", .normal = DEM_NORMAL_LINEAR, .step = 2.5},
    {"hysteretic", "t_c/50", .normal = DEM_NORMAL_HYSTERETIC}, {"other E", "1e8 Pa", .soften = 0.1},
    {"other E", "1e6 Pa", .soften = 0.001}, {"other E", "1e5 Pa", .soften = 1e-4},
    {"without memory", "viscous", .tangent = DEM_TANGENT_VISCOUS},
    {"without memory", "step", .tangent = DEM_TANGENT_STEP},
    {"friction", "Mindlin", .tangent = DEM_TANGENT_MINDLIN}};
enum { BED_CHOICES = (int)(sizeof bed_choices/sizeof *bed_choices), BED_SEEDS = 4 };
static outcome bed_out[BED_CHOICES*SCENE_SEEDS];
static int bed_done;
static int bed_all(void) {
    const int seeds = scene_seeds(BED_SEEDS);
    if (!bed_done++) scene_measure("bed", scene_bed, bed_choices, BED_CHOICES, seeds, bed_out);
    return seeds;
}
static void fill_bed_stress(points *p) { scene_errors(p, bed_choices, BED_CHOICES, bed_all(), bed_out, 0, 1); }
static void fill_bed_porosity(points *p) { scene_points(p, bed_choices, BED_CHOICES, bed_all(), bed_out, 1); }
static void fill_bed_energy(points *p) { scene_errors(p, bed_choices, BED_CHOICES, bed_all(), bed_out, 2, 1); }

/* ---- a gas of ellipsoids, 2 : 1 : 1, elastic ---- */

static int spheroids_build(built *b, const choice *c, int seed) {
    const dem_world_desc desc = dem_world_desc_get(b->world);
    const dem_real r = DEM_R(SCENE_RADIUS);
    const dem_shape shape = dem_shape_ellipsoid_add(b->world, dem_vec3_make(2*r, r, r));
    uint64_t state = (uint64_t)seed*977;
    int i, ok;
    b->stuff = scene_material(b->world, c, 1, 0, 0);
    ok = b->stuff.id && shape.id &&
         dem_bodies_fill(b->world, b->stuff, shape, dem_region_make(desc.domain), GAS_ELLIPSOIDS, (uint64_t)seed) == GAS_ELLIPSOIDS;
    for (i = 0; i < GAS_ELLIPSOIDS && ok; i++) { /* no spin about the long axis: nothing ever changes it    */
        const dem_body body = dem_body_id_get(b->world, i);
        dem_body_state s;
        ok = dem_body_get(b->world, body, &s) == DEM_OK;
        s.velocity = dem_vec3_make((dem_real)gas_random(&state), (dem_real)gas_random(&state),
                                   (dem_real)gas_random(&state));
        s.spin = dem_quat_rotate(s.orientation, dem_vec3_make(0, (dem_real)(141*gas_random(&state)),
                                                             (dem_real)(141*gas_random(&state))));
        ok = ok && dem_body_set(b->world, body, &s) == DEM_OK;
    }
    return ok;
}
/* value: change of the energy; T_r/T_t, mean of the second half. */
static outcome scene_spheroids(const choice *c, int seed) {
    const double time = quick ? 0.1 : 0.4;
    outcome o = {{0}, 0, 0, 1};
    dem_ledger l;
    dem_totals t;
    built b;
    double first;
    int k;
    if (!scene_build(&b, gas_desc(c, 2*GAS_ELLIPSOIDS*8*ACCURACY_PI/3*pow(SCENE_RADIUS, 3)), c, spheroids_build, seed))
        return o;
    t = dem_totals_get(b.world);
    first = t.kinetic + t.rotational;
    for (k = 0; k < 100 && scene_run(&b, time/100, &o); k++) {
        l = dem_ledger_get(b.world);
        o.value[0] = fmax(o.value[0], fabs((l.kinetic + l.rotational + l.elastic)/first - 1));
        if (k >= 50) o.value[1] += 1.5*l.rotational/l.kinetic/50;
    }
    scene_end(&b, &o);
    return o;
}
static void fill_spheroids(points *p) {
    static const choice c[] = {
        {.label = "t_c/200", .step = 0.25, .soften = 0.1}, {"conservative", "t_c/50", .soften = 0.1},
        {"conservative", "t_c/100", .step = 0.5, .soften = 0.1}, {"conservative", "t_c/20", .step = 2.5, .soften = 0.1},
        {"chord", "t_c/50", .overlap = DEM_OVERLAP_CHORD, .soften = 0.1},
        {"chord", "t_c/100", .overlap = DEM_OVERLAP_CHORD, .step = 0.5, .soften = 0.1},
        {"chord", "t_c/20", .overlap = DEM_OVERLAP_CHORD, .step = 2.5, .soften = 0.1},
        {"normal", "t_c/50", .overlap = DEM_OVERLAP_NORMAL, .soften = 0.1},
        {"normal", "t_c/100", .overlap = DEM_OVERLAP_NORMAL, .step = 0.5, .soften = 0.1},
        {"normal", "t_c/20", .overlap = DEM_OVERLAP_NORMAL, .step = 2.5, .soften = 0.1}};
    enum { COUNT = (int)(sizeof c/sizeof *c), SEEDS = 4 };
    static outcome out[COUNT*SCENE_SEEDS];
    const int seeds = scene_seeds(SEEDS);
    double bar, ratio;
    char what[72];
    int i;
    scene_measure("ellipsoids", scene_spheroids, c, COUNT, seeds, out);
    scene_errors(p, c, COUNT, seeds, out, 0, 0);
    for (i = 1; i < COUNT; i++) {
        ratio = scene_mean(out + i*SCENE_SEEDS, seeds, 1, &bar);
        snprintf(what, sizeof what, "T_r/T_t (theory: 1), %s, %s", c[i].series, c[i].label);
        points_number(p, what, ratio, bar, "1", seeds);
    }
}

/* ---- an ellipsoid 2 : 1 : 1 made of n spheres ---- */

enum { CLUSTER_MOST = 33, CLUSTER_BODIES = 60, CLUSTER_KINDS = 6 };
static const int cluster_counts[CLUSTER_KINDS] = {0, 3, 5, 9, 17, CLUSTER_MOST}; /* 0: the ellipsoid itself  */
/* Spheres along the axis, each as large as fits inside; mass and inertia are the ellipsoid's. */
static dem_shape cluster_shape(dem_world *world, int n) {
    const double b = SCENE_RADIUS, a = 2*b, volume = 4*ACCURACY_PI/3*a*b*b, most = (a*a - b*b)/a;
    dem_real x[3*CLUSTER_MOST], r[CLUSTER_MOST];
    dem_cluster_desc desc = DEM_CLUSTER_DESC;
    int i;
    if (!n) return dem_shape_ellipsoid_add(world, dem_vec3_make((dem_real)a, (dem_real)b, (dem_real)b));
    for (i = 0; i < n; i++) {
        const double at = most*(2.0*i/(n - 1) - 1);
        x[3*i] = (dem_real)at;
        x[3*i + 1] = x[3*i + 2] = 0;
        r[i] = (dem_real)(b*sqrt(1 - at*at/(a*a - b*b)));
    }
    desc.count = n;
    desc.positions = x;
    desc.radii = r;
    desc.mass = DEM_CLUSTER_GIVEN;
    desc.volume = (dem_real)volume;
    desc.inertia[0] = (dem_real)(volume*2*b*b/5);
    desc.inertia[1] = desc.inertia[2] = (dem_real)(volume*(a*a + b*b)/5);
    return dem_shape_cluster_add(world, &desc);
}
/* Thrown at a smooth plane at .1 m/s, tilted; leaving velocity against that of a rigid ellipsoid, over .1 m/s. */
static double cluster_rebound(int n, double tilt) {
    const double b = SCENE_RADIUS, a = 2*b, v = 0.1, s = sin(tilt), cosine = cos(tilt);
    const double h = sqrt(a*a*s*s + b*b*cosine*cosine), lever = (a*a - b*b)*s*cosine/h, inertia = (a*a + b*b)/5;
    const double expected = v*(2/(1 + lever*lever/inertia) - 1); /* impulse 2 v/(1/m + lever^2/I)                */
    choice c = {.soften = 100};
    dem_world_desc desc = scene_desc(&c, b, v);
    dem_world *world = dem_world_create(&desc);
    const dem_material stuff = scene_material(world, &c, 1, 0, 0);
    const dem_body body = dem_body_add(world, stuff, cluster_shape(world, n), dem_vec3_make(0, 0, (dem_real)(1.0001*h)),
                                       dem_quat_about(dem_vec3_make(0, 1, 0), (dem_real)-tilt));
    dem_body_state state;
    int ok = dem_body_get(world, body, &state) == DEM_OK, k, touched = 0;
    state.velocity.z = (dem_real)-v;
    ok = ok && dem_body_set(world, body, &state) == DEM_OK &&
         dem_wall_plane_add(world, stuff, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1)).id;
    for (k = 0; k < 2000000 && ok; k++) {
        int touches;
        ok = dem_world_step(world, 1) == DEM_OK;
        touches = dem_counters_get(world).wall_contacts;
        if (touched && !touches) break;
        touched |= touches;
    }
    ok = ok && touched && dem_body_get(world, body, &state) == DEM_OK;
    if (!ok) study_fail("cluster: %s", dem_world_error_get(world));
    dem_world_destroy(world);
    return ok ? (double)state.velocity.z/v - expected/v : (double)NAN;
}
static int cluster_build(built *b, const choice *c, int seed) {
    const dem_box box = dem_box_make(0, 0, 0, DEM_R(BED_SIDE), DEM_R(BED_SIDE), DEM_R(0.4));
    b->stuff = scene_material(b->world, c, 0.5, 0.5, 0);
    return b->stuff.id && dem_wall_plane_add(b->world, b->stuff, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1)).id &&
           dem_bodies_fill(b->world, b->stuff, cluster_shape(b->world, c->kind), dem_region_make(box),
                           CLUSTER_BODIES, (uint64_t)seed) ==
           CLUSTER_BODIES;
}
/* value: solid fraction of the bed into which they fall. */
static outcome scene_clusters(const choice *c, int seed) {
    outcome o = {{0}, 0, 0, 1};
    dem_world_desc desc = scene_desc(c, SCENE_RADIUS, 1);
    built b;
    desc.gravity.z = DEM_R(-9.81);
    desc.domain = dem_box_make(0, 0, 0, DEM_R(BED_SIDE), DEM_R(BED_SIDE), 1);
    desc.boundary[0] = desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
    if (!scene_build(&b, desc, c, cluster_build, seed)) return o;
    scene_run(&b, quick ? 0.1 : 0.4, &o);
    o.value[0] = CLUSTER_BODIES*8*ACCURACY_PI/3*pow(SCENE_RADIUS, 3)/
                 (BED_SIDE*BED_SIDE*2*dem_totals_get(b.world).centre[2]);
    scene_end(&b, &o);
    return o;
}
static outcome cluster_out[(CLUSTER_KINDS + 1)*SCENE_SEEDS];
static choice cluster_choices[CLUSTER_KINDS + 1];
static int cluster_done;
static int cluster_all(void) {   /* the first two are the ellipsoid: reference and unit of cost              */
    static char label[CLUSTER_KINDS][16];
    const int seeds = scene_seeds(3);
    int k;
    if (cluster_done++) return seeds;
    for (k = 0; k <= CLUSTER_KINDS; k++) {
        choice *c = &cluster_choices[k];
        c->kind = cluster_counts[k > 0 ? k - 1 : 0];
        if (k) snprintf(label[k - 1], sizeof label[k - 1], c->kind ? "n = %d" : "exact", c->kind);
        c->series = !k ? 0 : c->kind ? "spheres" : "ellipsoid";
        c->label = k ? label[k - 1] : "t_c/100";
        c->step = k ? 1 : 0.5;
    }
    scene_measure("clusters", scene_clusters, cluster_choices, CLUSTER_KINDS + 1, seeds, cluster_out);
    return seeds;
}
static void fill_cluster_rebound(points *p) {
    const int seeds = cluster_all();
    int k, i;
    for (k = 1; k <= CLUSTER_KINDS; k++) {
        double sum = 0;
        for (i = 0; i < 16; i++) sum += pow(cluster_rebound(cluster_choices[k].kind, (i + 0.5)*ACCURACY_PI/32), 2);
        points_add(p, cluster_choices[k].series, cluster_choices[k].label,
                   scene_cost(cluster_out + k*SCENE_SEEDS, cluster_out + SCENE_SEEDS, seeds), sqrt(sum/16), 0);
    }
}
static void fill_cluster_packing(points *p) {
    scene_points(p, cluster_choices, CLUSTER_KINDS + 1, cluster_all(), cluster_out, 0);
}

/* ---- skin and search: the drum of bench/scenes.h ---- */

enum { SKINS = 8, SEARCHES = 3, SKIN_TURNS = 3 };
static const double skins[SKINS] = {0.03, 0.06, 0.12, 0.25, 0.4, 0.6, 0.9, 1.4}; /* of the radius                */
/* Time of some steps; where the beads then are, in the order in which they were added. */
static double skin_time(const bench_scene *start, const bench_choice *how, bench_scene *end) {
    dem_world *world = bench_world(start, how);
    double begun, spent;
    int ok = world && dem_world_step(world, 50) == DEM_OK;
    begun = cpu_clock();
    ok = ok && dem_world_step(world, quick ? 30 : 150) == DEM_OK;
    spent = cpu_clock() - begun;
    if (ok) bench_scene_take(end, world);
    else study_fail("drum: %s", dem_world_error_get(world));
    dem_world_destroy(world);
    return spent;
}
static void fill_skin(points *p) {
    static const struct { dem_search which; const char *name; } searches[SEARCHES] = {
        {DEM_SEARCH_GRID, "grid"}, {DEM_SEARCH_HIERARCHICAL, "levels"}, {DEM_SEARCH_LINKED_LIST, "linked list"}};
    static double times[SEARCHES*SKINS + 2][BENCH_MOST_LOOPS];
    bench_scene start = bench_scene_read(data_folder, "drum"), first = bench_scene_make("drum", start.count);
    bench_scene end = bench_scene_make("drum", start.count);
    const int turns = quick ? 1 : SKIN_TURNS;
    double apart = 0;
    char label[32];
    int turn, k, i;
    for (turn = 0; turn < turns; turn++)
        for (k = 0; k < SEARCHES*SKINS + 2; k++) { /* the last two: the library's choice, and none           */
            bench_choice how = BENCH_CHOICE;
            study_progress("skin", (double)(turn*(SEARCHES*SKINS + 2) + k)/(turns*(SEARCHES*SKINS + 2)), 0);
            if (k < SEARCHES*SKINS) {
                how.search = searches[k/SKINS].which;
                how.skin = skins[k%SKINS]*BENCH_RADIUS;
            } else how.skin = k == SEARCHES*SKINS ? 0 : -1;
            times[k][turn] = skin_time(&start, &how, k ? &end : &first);
            for (i = 0; i < 3*start.count && k && !turn; i++)
                apart = fmax(apart, fabs(end.x[i] - first.x[i])/BENCH_RADIUS);
        }
    study_progress("skin", 1, 0);
    p->plain = 1;
    for (k = 0; k < SEARCHES*SKINS; k++) {
        snprintf(label, sizeof label, "%g R", skins[k%SKINS]);
        points_add(p, searches[k/SKINS].name, label, skins[k%SKINS],
                   bench_median_ratio(times[k], times[SEARCHES*SKINS], turns), 0);
    }
    p->mark = 1;
    p->mark_name = "chosen by the library";
    for (i = k = 0; k < p->count; k++) if (p->at[k].error < p->at[i].error) i = k;
    snprintf(label, sizeof label, "fastest, %s", p->at[i].label);
    points_number(p, label, p->at[i].error, 0, "time of a step [library's skin = 1]", 0);
    points_number(p, "no skin", bench_median_ratio(times[SEARCHES*SKINS + 1], times[SEARCHES*SKINS], turns), 0,
                  "time of a step [library's skin = 1]", 0);
    points_number(p, "largest difference of positions", apart, 0, "radii", 0);
    bench_scene_free(&start); bench_scene_free(&first); bench_scene_free(&end);
}
#endif /* ACCURACY_BEDS_H */
