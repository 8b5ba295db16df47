/* accuracy_impacts.h - one body: a bead that meets a plane head on or at an angle, a ball that bounces, a free top.
   MIT licence. Needs all that bench/accuracy.c includes before it. */
#ifndef ACCURACY_IMPACTS_H
#define ACCURACY_IMPACTS_H

enum { SCHEMES = 5, STEPS = 6, PHASES = 16, BOUNCES = 1000, ANGLES = 8 };
static const struct { dem_integrator which; const char *name; } schemes[SCHEMES] = {
    {DEM_INTEGRATOR_VELOCITY_VERLET, "velocity Verlet"}, {DEM_INTEGRATOR_LEAPFROG, "leapfrog"}, {DEM_INTEGRATOR_POSITION_VERLET, "position Verlet"},
    {DEM_INTEGRATOR_SYMPLECTIC_EULER, "symplectic Euler"}, {DEM_INTEGRATOR_FORWARD_EULER, "forward Euler"}};
static const double steps_of_contact[STEPS] = {20, 30, 50, 100, 200, 400};

/* ---- what a step costs on the bed of bench/scenes.h, over that of the library's own choice ---- */

enum { PRICES = 10, PRICE_TURNS = 5 };
static const struct { dem_integrator integrator; dem_tangent_law tangent; } priced[PRICES] = {
    {DEM_INTEGRATOR_VELOCITY_VERLET, DEM_TANGENT_AUTO}, {DEM_INTEGRATOR_LEAPFROG, DEM_TANGENT_AUTO}, {DEM_INTEGRATOR_POSITION_VERLET, DEM_TANGENT_AUTO},
    {DEM_INTEGRATOR_SYMPLECTIC_EULER, DEM_TANGENT_AUTO}, {DEM_INTEGRATOR_FORWARD_EULER, DEM_TANGENT_AUTO},
    {DEM_INTEGRATOR_VELOCITY_VERLET, DEM_TANGENT_VISCOUS}, {DEM_INTEGRATOR_VELOCITY_VERLET, DEM_TANGENT_STEP},
    {DEM_INTEGRATOR_VELOCITY_VERLET, DEM_TANGENT_SPRING}, {DEM_INTEGRATOR_VELOCITY_VERLET, DEM_TANGENT_MINDLIN},
    {DEM_INTEGRATOR_VELOCITY_VERLET, DEM_TANGENT_MINDLIN_RESCALED}};
static double price_ratio[PRICES];
static double price_seconds;        /* s of processor time, a step of the library's own choice on the bed    */

static void prices(void) { /* in turns; once                                                                */
    static double times[PRICES][BENCH_MOST_LOOPS];
    dem_world *worlds[PRICES];
    bench_scene bed;
    int k, turn, ok = 1, turns = quick ? 1 : PRICE_TURNS;
    if (price_seconds > 0) return;
    bed = bench_scene_read(data_folder, "bed");
    for (k = 0; k < PRICES; k++) {
        bench_choice how = BENCH_CHOICE;
        how.integrator = priced[k].integrator;
        how.tangent = priced[k].tangent;
        worlds[k] = bench_world(&bed, &how);
        ok = ok && worlds[k] && dem_world_step(worlds[k], 40) == DEM_OK;
    }
    for (turn = 0; turn < turns && ok; turn++)
        for (k = 0; k < PRICES && ok; k++) {
            const double begun = cpu_clock();
            ok = dem_world_step(worlds[k], 50) == DEM_OK;
            times[k][turn] = (cpu_clock() - begun)/50;
        }
    for (k = 0; k < PRICES; k++) {
        price_ratio[k] = ok ? bench_median_ratio(times[k], times[0], turns) : (double)NAN;
        dem_world_destroy(worlds[k]);
    }
    price_seconds = ok ? bench_median(times[0], turns) : (double)NAN;
    bench_scene_free(&bed);
    if (!ok) study_fail("the bed broke");
}
/* What a step on the bed costs in each build. */
static void variant_price(FILE *page) {
    static const char *const names[2] = {"single", "one_domain"};
    static const char *const what[2] = {"single precision", "all bodies in one domain, no threads"};
    note n;
    int k;
    if (variant_file) {
        prices();
        variant_note("price", "bed", 1, price_seconds, 0, 0);
    }
    if (page) fprintf(page, "| build | time of a step on the bed [ordinary build = 1] |\n|---|---|\n");
    for (k = 0; k < 2 && page; k++) {
        if (!variant_notes(names[k], "price", &n, 1)) continue;
        prices();
        bench_result_short(names[k], n.unit/price_seconds, "of the time of a step on the bed");
        fprintf(page, "| %s | %.2f |\n", what[k], n.unit/price_seconds);
    }
}
static double price_of(dem_integrator integrator, dem_tangent_law tangent) {
    int k;
    prices();
    for (k = 0; k < PRICES; k++)
        if (priced[k].integrator == integrator && priced[k].tangent == tangent) return price_ratio[k];
    return 1;
}

/* ---- a bead of 1.5 mm meets a plane head on at 1 m/s ---- */

/* A bead between planes at z = 0 and, when gap > 0, z = 2 r + gap. */
static dem_world *bounce_world(dem_integrator which, double dt, double height, double gap, double restitution) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc m = DEM_MATERIAL_DESC;
    dem_material glass;
    dem_body body;
    dem_body_state state;
    dem_world *world;
    int ok;
    desc.integrator = which;
    desc.dt = (dem_real)dt;
    desc.allow_large_dt = 1;         /* twenty steps may be just too few by rounding                         */
    desc.impact_speed = 1;
    desc.threads = 1;
    world = dem_world_create(&desc);
    if (!world) { study_fail("bounce: %s", dem_world_create_error_get(&desc)); return 0; }
    m.density = (dem_real)BENCH_DENSITY;
    m.young = (dem_real)BENCH_YOUNG;
    m.poisson = (dem_real)BENCH_POISSON;
    m.restitution = (dem_real)restitution;
    glass = dem_material_add(world, &m);
    body = dem_sphere_add(world, glass, (dem_real)BENCH_RADIUS, dem_vec3_make(0, 0, (dem_real)(BENCH_RADIUS + height)));
    ok = dem_body_get(world, body, &state) == DEM_OK;
    state.velocity.z = -1;
    ok = ok && dem_body_set(world, body, &state) == DEM_OK &&
         dem_wall_plane_add(world, glass, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1)).id &&
         (gap <= 0 || dem_wall_plane_add(world, glass, dem_vec3_make(0, 0, (dem_real)(2*BENCH_RADIUS + gap)),
                                    dem_vec3_make(0, 0, -1)).id);
    if (ok) return world;
    study_fail("bounce: %s", dem_world_error_get(world));
    dem_world_destroy(world);
    return 0;
}
static double contact_time(void) {
    dem_world *world = bounce_world(DEM_INTEGRATOR_VELOCITY_VERLET, 0, 1e-4, 0, 1);
    dem_advice advice;
    double t = 0;
    if (world && dem_step_advice_get(world, &advice) == DEM_OK) t = (double)advice.contact_time;
    dem_world_destroy(world);
    return t;
}
static double kinetic(const dem_world *world) { return dem_totals_get(world).kinetic; }

/* Relative error of energy (restitution 1) or of restitution, root mean square over instants of first touch. */
static double bounce_error(dem_integrator which, double tc, double steps, double restitution) {
    const double dt = tc/steps;
    double sum = 0;
    int phase;
    for (phase = 0; phase < PHASES; phase++) {
        dem_world *world = bounce_world(which, dt, dt*(3 + (phase + 0.5)/PHASES), 0, restitution);
        double before, error;
        if (!world) return (double)NAN;
        before = kinetic(world);
        if (dem_world_step(world, (int)(1.5*steps) + 10) != DEM_OK) study_fail("%s", dem_world_error_get(world));
        error = kinetic(world)/before;
        error = restitution < 1 ? sqrt(error)/restitution - 1 : error - 1;
        sum += error*error;
        dem_world_destroy(world);
    }
    return sqrt(sum/PHASES);
}
/* Energy after BOUNCES of them over that before; free flight between takes a contact time. NAN: the run broke. */
static double long_run(dem_integrator which, double tc) {
    dem_world *world = bounce_world(which, tc/50, 0.37*tc, tc, 1);
    double before, most = 0;
    int k, broken = 0;
    if (!world) return (double)NAN;
    before = kinetic(world);
    for (k = 0; k < 20*BOUNCES && !broken; k++) { /* a bounce and a flight are 100 steps                     */
        broken = dem_world_step(world, 5) != DEM_OK;
        if (k >= 20*(BOUNCES - 1)) most = fmax(most, kinetic(world)); /* that of flight                      */
    }
    dem_world_destroy(world);
    return broken ? (double)NAN : most/before;
}
static void bounces(points *p, double restitution) {
    const double tc = contact_time();
    char label[32], what[72];
    int k, n;
    for (k = 0; k < SCHEMES; k++) {
        double error[STEPS];
        for (n = 0; n < STEPS; n++) {
            error[n] = bounce_error(schemes[k].which, tc, steps_of_contact[n], restitution);
            snprintf(label, sizeof label, "t_c/%.0f", steps_of_contact[n]);
            points_add(p, schemes[k].name, label, price_of(schemes[k].which, DEM_TANGENT_AUTO)*steps_of_contact[n]/50,
                       error[n], 0);
        }
        snprintf(what, sizeof what, "order from t_c/50 to t_c/400, %s", schemes[k].name);
        points_number(p, what, log(error[2]/error[5])/log(8.0), 0, "1", 0);
    }
    if (restitution < 1) return;
    for (k = 0; k < SCHEMES; k++) {
        const double energy = long_run(schemes[k].which, tc); /* NAN: the run was stopped                        */
        snprintf(what, sizeof what, "energy after %d bounces at t_c/50, %s", BOUNCES, schemes[k].name);
        points_number(p, what, energy, 0, "1", 0);
    }
}
static void fill_restitution(points *p) { bounces(p, 0.66); }
static void fill_energy(points *p) { bounces(p, 1); }

/* ---- oblique impacts: an aluminium oxide bead of 2.5 mm at 3.9 m/s, as MFiX DEM05 and Chung & Ooi test 4 ---- */

typedef struct shot {
    dem_integrator integrator;
    dem_tangent_law tangent;
    dem_slider slider;
    int linear;                      /* 1: kn 1.72e7, kt 1.48e7 N/m, no damping, friction .092               */
    double steps, phase;             /* steps in an elastic contact; share of a step to first touch          */
} shot;
static const double shot_angle[ANGLES] = {5, 10, 15, 20, 25, 30, 45, 60}; /* degrees from the normal         */

/* Leaving tangential velocity and R omega over the arriving speed. 0: the run broke. */
static int shot_fire(const shot *s, double degrees, double out[2]) {
    const double r = 2.5e-3, m = 4000*4*ACCURACY_PI/3*r*r*r, speed = 3.9, angle = degrees*ACCURACY_PI/180;
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = DEM_MATERIAL_DESC;
    dem_material oxide;
    dem_pair pair;
    dem_body body;
    dem_body_state state;
    dem_world *world;
    double tc, dt;
    int ok;
    const double young = 380e9/(1 - 0.23*0.23)/2, v = speed*cos(angle); /* bead and plane alike           */
    tc = s->linear ? ACCURACY_PI*sqrt(m/1.72e7) : 2.94327518/v*pow(15*m*v*v/(16*young*sqrt(r)), 0.4);
    dt = tc/s->steps;
    desc.threads = 1;
    desc.dt = (dem_real)dt;
    desc.allow_large_dt = 1;
    desc.integrator = s->integrator;
    desc.tangent_law = s->tangent;
    desc.slider = s->slider;
    desc.normal_law = s->linear ? DEM_NORMAL_LINEAR : DEM_NORMAL_HERTZ;
    world = dem_world_create(&desc);
    if (!world) { study_fail("shot: %s", dem_world_create_error_get(&desc)); return 0; }
    stuff.density = 4000;
    stuff.young = DEM_R(380e9);
    stuff.poisson = DEM_R(0.23);
    stuff.restitution = s->linear ? 1 : DEM_R(0.66);
    stuff.friction = s->linear ? DEM_R(0.092) : DEM_R(0.2);
    oxide = dem_material_add(world, &stuff);
    ok = dem_pair_get(world, oxide, oxide, &pair) == DEM_OK;
    if (s->linear) { pair.stiffness = DEM_R(1.72e7); pair.stiffness_ratio = DEM_R(1.48/1.72); }
    ok = ok && dem_pair_set(world, oxide, oxide, &pair) == DEM_OK &&
         dem_wall_plane_add(world, oxide, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1)).id;
    body = dem_sphere_add(world, oxide, (dem_real)r, dem_vec3_make(0, 0, (dem_real)(r + s->phase*dt*v)));
    ok = ok && dem_body_get(world, body, &state) == DEM_OK;
    state.velocity = dem_vec3_make((dem_real)(speed*sin(angle)), 0, (dem_real)-v);
    ok = ok && dem_body_set(world, body, &state) == DEM_OK && dem_world_step(world, (int)(2*s->steps) + 6) == DEM_OK &&
         dem_body_get(world, body, &state) == DEM_OK;
    if (!ok) study_fail("shot: %s", dem_world_error_get(world));
    out[0] = (double)state.velocity.x/speed;
    out[1] = r*(double)state.spin.y/speed;
    dem_world_destroy(world);
    return ok;
}
/* Root mean square over angles and instants of first touch of how far both are from their converged answers. */
static double shot_error(shot s, double converged[ANGLES][2]) {
    const int phases = quick ? 2 : 8;
    double sum = 0, out[2];
    int i, k;
    for (i = 0; i < ANGLES; i++)
        for (k = 0; k < phases; k++) {
            s.phase = (k + 0.5)/phases;
            if (!shot_fire(&s, shot_angle[i], out)) return (double)NAN;
            sum += pow(out[0] - converged[i][0], 2) + pow(out[1] - converged[i][1], 2);
        }
    return sqrt(sum/(2*ANGLES*phases));
}
static void shot_series(points *p, const char *name, shot s, double converged[ANGLES][2]) {
    char label[32];
    int i;
    shot fine = s;
    fine.steps = quick ? 6400 : 25600;
    for (i = 0; i < ANGLES; i++) if (!shot_fire(&fine, shot_angle[i], converged[i])) return;
    for (i = 0; i < STEPS; i++) {
        s.steps = steps_of_contact[i];
        snprintf(label, sizeof label, "t_c/%.0f", s.steps);
        points_add(p, name, label, price_of(s.integrator, s.tangent)*s.steps/50, shot_error(s, converged), 0);
    }
}
static void fill_oblique(points *p) {
    static const struct { const char *name; dem_tangent_law law; dem_slider slider; } laws[] = {
        {"spring", DEM_TANGENT_SPRING, DEM_SLIDER_PARALLEL},
        {"spring, DEM_SLIDER_SPRING", DEM_TANGENT_SPRING, DEM_SLIDER_SPRING},
        {"spring, DEM_SLIDER_REMAINDER", DEM_TANGENT_SPRING, DEM_SLIDER_REMAINDER},
        {"Mindlin", DEM_TANGENT_MINDLIN, DEM_SLIDER_PARALLEL},
        {"Mindlin, DEM_SLIDER_REMAINDER", DEM_TANGENT_MINDLIN, DEM_SLIDER_REMAINDER},
        {"Mindlin rescaled", DEM_TANGENT_MINDLIN_RESCALED, DEM_SLIDER_PARALLEL},
        {"step, without memory", DEM_TANGENT_STEP, DEM_SLIDER_PARALLEL},
        {"viscous, without memory", DEM_TANGENT_VISCOUS, DEM_SLIDER_PARALLEL}};
    double converged[8][ANGLES][2], apart;
    char what[80];
    int k, i;
    for (k = 0; k < 8; k++) {
        shot s = {DEM_INTEGRATOR_VELOCITY_VERLET, laws[k].law, laws[k].slider, 0, 0, 0};
        shot_series(p, laws[k].name, s, converged[k]);
    }
    for (k = 1; k < 8; k++) {
        for (apart = i = 0; i < ANGLES; i++)
            apart += pow(converged[k][i][0] - converged[0][i][0], 2) + pow(converged[k][i][1] - converged[0][i][1], 2);
        snprintf(what, sizeof what, "difference from the spring, both converged: %s", laws[k].name);
        points_number(p, what, sqrt(apart/(2*ANGLES)), 0, "1", 0);
    }
}
/* MFiX's own figures: leaving over arriving tangential velocity. */
static void fill_oblique_mfix(points *p) {
    static const double mfix[ANGLES] = {0.7981, 0.6556, 0.5971, 0.5946, 0.6219, 0.6813, 0.8160, 0.8938};
    double converged[ANGLES][2], apart = 0;
    int k, i;
    for (k = 0; k < SCHEMES; k++) {
        shot s = {DEM_INTEGRATOR_VELOCITY_VERLET, DEM_TANGENT_SPRING, DEM_SLIDER_PARALLEL, 1, 0, 0};
        double own[ANGLES][2];
        s.integrator = schemes[k].which;
        shot_series(p, schemes[k].name, s, own);
        if (!k) memcpy(converged, own, sizeof converged);
    }
    for (i = 0; i < ANGLES; i++) apart += pow(converged[i][0] - mfix[i]*sin(shot_angle[i]*ACCURACY_PI/180), 2);
    p->mark = sqrt(apart/ANGLES);
    p->mark_name = "MFiX DEM05, its published figures against our converged ones (velocity only)";
}

/* ---- a ball bounces for 10 s: MFiX DEM02 ---- */

/* Largest departure of the height of a bounce from that at first, `height` m of fall; NAN: the run broke. */
static double ball_one(dem_integrator which, double steps, double height) {
    const double r = 0.1, k = 5e4, m = 2600*4*ACCURACY_PI/3*r*r*r, g = 9.81, first = m*g*height;
    const double dt = ACCURACY_PI*sqrt(m/k)/steps;
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = DEM_MATERIAL_DESC;
    dem_material rubber;
    dem_pair pair;
    dem_body body;
    dem_body_state state;
    dem_world *world;
    double worst = 0, v, z;
    int i, ok;
    desc.threads = 1;
    desc.dt = (dem_real)dt;
    desc.allow_large_dt = 1;
    desc.integrator = which;
    desc.gravity.z = DEM_R(-9.81);
    desc.normal_law = DEM_NORMAL_LINEAR;
    world = dem_world_create(&desc);
    if (!world) { study_fail("ball: %s", dem_world_create_error_get(&desc)); return (double)NAN; }
    stuff.density = 2600;
    stuff.young = DEM_R(1e7);
    stuff.restitution = 1;
    rubber = dem_material_add(world, &stuff);
    ok = dem_pair_get(world, rubber, rubber, &pair) == DEM_OK;
    pair.stiffness = (dem_real)k;
    ok = ok && dem_pair_set(world, rubber, rubber, &pair) == DEM_OK &&
         dem_wall_plane_add(world, rubber, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1)).id;
    body = dem_sphere_add(world, rubber, DEM_R(0.1), dem_vec3_make(0, 0, (dem_real)(0.1 + height)));
    for (i = 0; i < (int)(10/dt) && ok; i++) {
        ok = dem_world_step(world, 1) == DEM_OK && dem_body_get(world, body, &state) == DEM_OK;
        v = (double)state.velocity.z;
        z = (double)state.position.z - r;
        if (ok && z > 0.01) worst = fmax(worst, fabs((m*v*v/2 + m*g*z)/first - 1));
    }
    dem_world_destroy(world);
    return ok ? worst : (double)NAN;
}
/* Root mean square over falls that differ a little: a ball that always returns hits at the same part of a step. */
static double ball_error(dem_integrator which, double steps) {
    const int heights = quick ? 3 : 24;
    double sum = 0;
    int i;
    for (i = 0; i < heights; i++) sum += pow(ball_one(which, steps, 0.4 + 0.03*i/heights), 2);
    return sqrt(sum/heights);
}
static void fill_ball(points *p) {
    char label[32];
    int k, n;
    for (k = 0; k < SCHEMES; k++)
        for (n = 0; n < STEPS; n++) {
            const double error = ball_error(schemes[k].which, steps_of_contact[n]);
            snprintf(label, sizeof label, "t_c/%.0f", steps_of_contact[n]);
            if (error < 10) points_add(p, schemes[k].name, label, price_of(schemes[k].which, DEM_TANGENT_AUTO)*
                                       steps_of_contact[n]/50, error, 0);
            if (!k) variant_note(p->name, label, steps_of_contact[n]/50, price_seconds, error, 0);
        }
    variant_points(p, price_seconds, 0, 0);
    p->mark = 16*5.5e-5;
    p->mark_name = "MFiX: 0.0055 % a bounce, 16 bounces";
}

/* ---- a free top: moments 1, 2, 3, spin (1, 1, 1), for 10 s ---- */

enum { TOPS = 256 };
static double top_error(dem_rotation rotation, double dt, double *seconds) {
    static const double exact[4] = {0.46254544, -0.31433515, 0.04942963, 0.82752755};
    const dem_real origin[3] = {0, 0, 0};
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = DEM_MATERIAL_DESC;
    dem_cluster_desc top = DEM_CLUSTER_DESC;
    dem_material material;
    dem_shape shape;
    dem_body body;
    dem_body_state s;
    dem_world *world;
    double begun, plus = 0, minus = 0;
    int i, ok = 1;
    desc.threads = 1;
    desc.dt = (dem_real)dt;
    desc.allow_large_dt = 1;         /* nothing touches                                                      */
    desc.rotation = rotation;
    world = dem_world_create(&desc);
    stuff.density = 1;
    stuff.young = DEM_R(1e6);
    stuff.restitution = DEM_R(0.5);
    material = dem_material_add(world, &stuff);
    top.count = 1;
    top.positions = origin;
    top.radius = 1;
    top.mass = DEM_CLUSTER_GIVEN;
    top.volume = 1;
    for (i = 0; i < 3; i++) top.inertia[i] = (dem_real)(i + 1);
    shape = dem_shape_cluster_add(world, &top);
    for (i = 0; i < TOPS && ok; i++) {
        body = dem_body_add(world, material, shape, dem_vec3_make((dem_real)(3*i), 0, 0), dem_quat_make(1, 0, 0, 0));
        ok = dem_body_get(world, body, &s) == DEM_OK;
        s.spin = dem_vec3_make(1, 1, 1);
        ok = ok && dem_body_set(world, body, &s) == DEM_OK;
    }
    begun = cpu_clock();
    ok = ok && dem_world_step(world, (int)(10/dt + 0.5)) == DEM_OK && dem_body_get(world, body, &s) == DEM_OK;
    *seconds = cpu_clock() - begun;
    if (!ok) study_fail("top: %s", dem_world_error_get(world));
    const double q[4] = {(double)s.orientation.w, (double)s.orientation.x, (double)s.orientation.y,
                         (double)s.orientation.z};
    for (i = 0; i < 4; i++) { plus += pow(q[i] - exact[i], 2); minus += pow(q[i] + exact[i], 2); }
    dem_world_destroy(world);
    return ok ? 2*sqrt(fmin(plus, minus)) : (double)NAN;
}
static void fill_top(points *p) {
    static const struct { dem_rotation which; const char *name; } rotations[3] = {
        {DEM_ROTATION_SPIRAL, "SPIRAL"}, {DEM_ROTATION_FINCHAM, "Fincham"}, {DEM_ROTATION_NO_SQUISH, "NO_SQUISH"}};
    static const double dts[] = {0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002};
    double unit = 0, seconds[5], error = 0;
    char label[32];
    int k, n, turn;
    for (turn = 0; turn < 5; turn++) top_error(DEM_ROTATION_SPIRAL, 0.01, &seconds[turn]);
    unit = bench_median(seconds, 5);
    for (k = 0; k < 3; k++)
        for (n = 0; n < 7; n++) {
            for (turn = 0; turn < 3; turn++) error = top_error(rotations[k].which, dts[n], &seconds[turn]);
            snprintf(label, sizeof label, "%g s", dts[n]);
            points_add(p, rotations[k].name, label, bench_median(seconds, 3)/unit, error, 0);
            if (!k) variant_note(p->name, label, bench_median(seconds, 3)/unit, unit, error, 0);
        }
    variant_points(p, unit, 0, 0);
}
#endif /* ACCURACY_IMPACTS_H */
