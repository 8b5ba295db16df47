/* Contact laws at the edge of what a time step resolves: their order, rest under rolling
   resistance, and what is said of time steps that cannot be right. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const double pi = 3.14159265358979323846;
static const double small = sizeof(dem_real) == 4 ? 1 : 0;  /* single precision: coarser limits */

/* --- order --- */

/* A ball that is pressed on a plane by gravity and swings in its contact without ever leaving it,
   so that no instant of touch lies within a step: its speed along the plane and its spin after a
   given time, in steps steps. pull: m/s along the plane at first; turn: rad/s. */
typedef struct swing { dem_normal_law normal; dem_tangent_law tangent; dem_rolling_law rolling;
                       double restitution, friction, rolling_friction, pull, turn; } swing;
typedef struct swung { double speed, spin, height; } swung;
static swung swing_for(swing s, int steps) {
    const double radius = 0.01, mass = 2500*4.0/3*pi*radius*radius*radius, young = 1e7;
    const double kn = s.normal == DEM_NORMAL_HERTZ ? 4.0/3*young/2/(1 - 0.0625)*sqrt(radius) : 1e4;
    const double rest = s.normal == DEM_NORMAL_HERTZ ? pow(mass*9.81/kn, 2.0/3) : mass*9.81/kn;
    const double omega = s.normal == DEM_NORMAL_HERTZ ? sqrt(1.5*kn*sqrt(rest)/mass)
        : sqrt(kn/mass);
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc m = scene_stuff(young, s.restitution, s.friction, s.rolling_friction);
    dem_material stuff;
    dem_world *world;
    dem_body ball;
    dem_body_state state;
    swung out;
    desc.gravity = at(0, 0, -9.81);
    desc.threads = 1;
    desc.normal_law = s.normal;
    desc.tangent_law = s.tangent;
    desc.rolling_law = s.rolling;
    desc.dt = (dem_real)(8/omega/steps);
    desc.allow_large_dt = 1;
    if (s.normal != DEM_NORMAL_HERTZ) m.stiffness = (dem_real)kn;
    world = dem_world_create(&desc);
    stuff = dem_material_add(world, &m);
    dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1));
    ball = dem_sphere_add(world, stuff, (dem_real)radius, at(0, 0, radius - 1.5*rest));
    scene_move(world, ball, at(s.pull, 0, 0), at(0, s.turn, 0));
    scene_step(world, steps);
    state = scene_state(world, ball);
    out.speed = (double)state.velocity.x;
    out.spin = (double)state.spin.y;
    out.height = (double)state.position.z - radius;
    dem_world_destroy(world);
    return out;
}
/* The order from three steps, each half of the last, of what a law's memory moves. */
static double order_of(swing s) {
    const swung a = swing_for(s, 400), b = swing_for(s, 800), c = swing_for(s, 12800);
    const double ea = fabs(a.spin - c.spin), eb = fabs(b.spin - c.spin);
    return log(ea/eb)/log(2.0);
}
static swing swing_make(dem_normal_law normal, dem_tangent_law tangent, dem_rolling_law rolling) {
    swing s;
    memset(&s, 0, sizeof s);
    s.normal = normal;
    s.tangent = tangent;
    s.rolling = rolling;
    s.restitution = 1;
    s.friction = rolling == DEM_ROLLING_NONE ? 10 : 0;
    s.rolling_friction = rolling == DEM_ROLLING_NONE ? 0 : 0.3;
    s.pull = rolling == DEM_ROLLING_NONE ? 1e-3 : 0;
    s.turn = rolling == DEM_ROLLING_NONE ? 0 : 0.1;
    return s;
}

/* --- rolling --- */

/* How far a ball creeps down a slope of 5 degrees between .5 and 1 s, in radii; mu_r .2 holds
   it. */
static double creep(dem_rolling_law law, double dt) {
    const double angle = 5*pi/180, radius = 0.01;
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc m = scene_stuff(1e7, 0.3, 0.5, 0.2);
    dem_material stuff;
    dem_world *world;
    dem_body ball;
    double x;
    desc.gravity = at(9.81*sin(angle), 0, -9.81*cos(angle));
    desc.threads = 1;
    desc.normal_law = DEM_NORMAL_LINEAR;
    desc.rolling_law = law;
    desc.dt = (dem_real)dt;
    m.stiffness = 1000;
    world = dem_world_create(&desc);
    stuff = dem_material_add(world, &m);
    dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1));
    ball = dem_sphere_add(world, stuff, (dem_real)radius, at(0, 0, radius));
    scene_step(world, (int)(0.5/dt + 0.5));
    x = (double)scene_state(world, ball).position.x;
    scene_step(world, (int)(0.5/dt + 0.5));
    x = (double)scene_state(world, ball).position.x - x;
    dem_world_destroy(world);
    return x/radius;
}

/* --- friction --- */

/* Friction's impulse over mu times the impulse of the normal force, of a sphere that slides all
   through an impact. */
static double friction_share(double e, dem_normal_law normal) {
    const double mu = 0.1, radius = 0.01;
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc m = scene_stuff(1e8, e, mu, 0);
    dem_material stuff;
    dem_world *world;
    dem_body ball;
    dem_body_state s;
    int i;
    desc.threads = 1;
    desc.normal_law = normal;
    desc.friction_load = DEM_LOAD_ELASTIC;
    m.stiffness = normal == DEM_NORMAL_HERTZ ? 0 : DEM_R(1e5);
    desc.dt = DEM_R(2e-7);
    world = dem_world_create(&desc);
    stuff = dem_material_add(world, &m);
    dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1));
    ball = dem_sphere_add(world, stuff, (dem_real)radius, at(0, 0, radius));
    scene_move(world, ball, at(5, 0, -1), at(0, 0, 0));
    for (i = 0; i < 20000; i++) {
        if (scene_step(world, 1) != DEM_OK) break;
        s = scene_state(world, ball);
        if ((double)s.position.z > radius) break;
    }
    s = scene_state(world, ball);
    dem_world_destroy(world);
    return (5 - (double)s.velocity.x)/(mu*(1 + (double)s.velocity.z));
}


/* --- [THO13]: a sphere of 25 mm meets a plane at 5 m/s and an angle --- */

/* psi: slip before over mu (1 + e) v_n/2. Answers slip and -R omega after, in the same measure. */
typedef struct rebound { double slip, spin, e, energy; } rebound;
static rebound oblique(dem_normal_law normal, dem_tangent_law law, dem_slider slider,
                       dem_tension tension, dem_load load, double e, double psi, int steps) {
    const double radius = 0.025, mu = 0.1, v = 5, unit = mu*(1 + e)*v/2;
    const double mass = 2650*4.0/3*pi*radius*radius*radius, kn = 1e8;
    const double young = 70e9/(1 - 0.09);
    const double overlap = pow(15*mass*v*v/(16*young*sqrt(radius)), 0.4);
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc m = DEM_MATERIAL_DESC;
    dem_material stuff;
    dem_pair pair;
    dem_world *world;
    dem_body ball;
    dem_body_state s;
    rebound out;
    int i;
    desc.threads = 1;
    desc.normal_law = normal;
    desc.tangent_law = law;
    desc.slider = slider;
    desc.tension = tension;
    desc.friction_load = load;
    desc.dt = (dem_real)((normal == DEM_NORMAL_HERTZ ? 2.94327518*overlap/v
                          : pi*sqrt(mass/kn))/steps);
    desc.allow_large_dt = 1;
    world = dem_world_create(&desc);
    m.density = 2650;
    m.young = DEM_R(70e9);
    m.poisson = DEM_R(0.3);
    m.restitution = (dem_real)e;
    m.friction = (dem_real)mu;
    if (normal != DEM_NORMAL_HERTZ) m.stiffness = (dem_real)kn;
    stuff = dem_material_add(world, &m);
    dem_pair_get(world, stuff, stuff, &pair);
    pair.young_eff = (dem_real)young;
    pair.shear_eff = (dem_real)(70e9/(2*1.3*1.7));
    dem_pair_set(world, stuff, stuff, &pair);
    dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1));
    ball = dem_sphere_add(world, stuff, (dem_real)radius, at(0, 0, radius));
    scene_move(world, ball, at(psi*unit, 0, -v), at(0, 0, 0));
    for (i = 0; i < 10*steps; i++) {
        scene_step(world, 1);
        s = scene_state(world, ball);
        if ((double)s.position.z > radius || (tension != DEM_TENSION_ALLOWED &&
            (double)s.velocity.z > 0 && (double)s.force.z <= 0)) break;
    }
    s = scene_state(world, ball);
    dem_world_destroy(world);
    out.slip = ((double)s.velocity.x - radius*(double)s.spin.y)/unit;
    out.spin = -radius*(double)s.spin.y/unit;
    out.e = (double)s.velocity.z/v;
    return out;
}
/* Sum of differences over the sum of sizes, in per cent: slip at e = .5, read off the paper's
   figures by Kratos (DEMApplication, benchmarks 10 and 11). */
static double slip_missed(dem_normal_law normal, dem_tangent_law law, dem_slider slider,
                          dem_tension tension) {
    static const double hertz[][2] = {{0.2044, 0.0182}, {1.1378, 0.0368}, {2.3289, -0.0360},
        {3.5467, -0.6000}, {4.8311, -0.7578}, {5.7600, -0.7676}, {6.1956, -0.6417},
        {6.3689, -0.5914}, {7.6756, 0.7180}, {9.3156, 2.3547}};
    static const double linear[][2] = {{0.2044, 0.0150}, {1.1422, -0.0136}, {2.3244, -0.2595},
        {3.5511, -0.6787}, {4.8311, -0.8176}, {5.7600, -0.7644}, {6.1911, -0.6386},
        {6.3689, -0.5946}, {7.6756, 0.7211}, {9.3200, 2.3516}};
    double off = 0, size = 0;
    int i;
    for (i = 0; i < 10; i++) {
        const double *row = normal == DEM_NORMAL_HERTZ ? hertz[i] : linear[i];
        off += fabs(oblique(normal, law, slider, tension, DEM_LOAD_ELASTIC, 0.5, row[0],
                            1000).slip - row[1]);
        size += fabs(row[1]);
    }
    return 100*off/size;
}
/* The same for spins, at four restitutions. */
static double spin_missed(dem_slider slider, int which) {
    static const double e[4] = {0.9, 0.75, 0.5, 0.25};
    static const double rows[4][7][2] = {
        {{0.8840, -0.4176}, {1.8182, -1.2755}, {2.7837, -2.4934}, {3.7931, -3.5505},
         {4.8652, -4.4276}, {6.0251, -4.9410}, {7.3229, -4.9758}},
        {{0.9655, -0.5670}, {1.9812, -1.3866}, {3.0345, -2.5892}, {4.1379, -3.6540},
         {5.3041, -4.5503}, {6.0690, -4.9181}, {7.9749, -4.9798}},
        {{0.2257, -0.1685}, {1.1661, -0.8274}, {2.3574, -1.7160}, {3.5737, -2.8727},
         {4.8527, -3.9681}, {6.3950, -4.9335}, {7.7116, -5.0027}},
        {{0.2759, -0.1762}, {1.3918, -0.9959}, {2.8088, -2.1986}, {4.2633, -3.3017},
         {5.7931, -4.3743}, {6.6583, -4.8914}, {7.4107, -4.9720}}};
    double off = 0, size = 0;
    int i;
    for (i = 0; i < 7; i++) {
        off += fabs(oblique(DEM_NORMAL_HERTZ, DEM_TANGENT_MINDLIN_RESCALED, slider,
                            DEM_TENSION_COMPENSATED, DEM_LOAD_REPULSIVE, e[which], rows[which][i][0],
                            1000).spin - rows[which][i][1]);
        size += fabs(rows[which][i][1]);
    }
    return 100*off/size;
}

/* --- time steps --- */

/* Spheres in a close packing whose contacts are all pressed by `depth` radii, periodic. Steps it
   with the largest dt that is accepted (frac of it) and answers the largest speed over the shaking
   speed given at first, or -1 when the step is refused by name. */
static double pressed(double depth, double frac) {
    const double radius = 1e-3, pitch = 2*radius*(1 - depth/2), a = pitch*sqrt(2.0);
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc m = scene_stuff(1e9, 1, 0.5, 0);
    dem_material stuff;
    dem_world *world;
    dem_advice advice;
    dem_result result;
    dem_real x[3*256], v[3*256];
    uint64_t seed = 7;
    double fastest = 0;
    int i, j, k, l, n = 0;
    desc.threads = 1;
    desc.domain = box_of(0, 0, 0, 4*a, 4*a, 4*a);
    for (i = 0; i < 3; i++) desc.boundary[i] = DEM_BOUNDARY_PERIODIC;
    world = dem_world_create(&desc);
    stuff = dem_material_add(world, &m);
    for (i = 0; i < 4; i++) for (j = 0; j < 4; j++)
    for (k = 0; k < 4; k++) for (l = 0; l < 4; l++) {
        x[n] = (dem_real)((i + (l == 1 || l == 2 ? 0.5 : 0) + 0.1)*a);
        x[n + 1] = (dem_real)((j + (l == 1 || l == 3 ? 0.5 : 0) + 0.1)*a);
        x[n + 2] = (dem_real)((k + (l == 2 || l == 3 ? 0.5 : 0) + 0.1)*a);
        v[n] = (dem_real)(1e-4*(2*scene_random(&seed) - 1));
        v[n + 1] = (dem_real)(1e-4*(2*scene_random(&seed) - 1));
        v[n + 2] = (dem_real)(1e-4*(2*scene_random(&seed) - 1));
        n += 3;
    }
    dem_spheres_add(world, stuff, 256, x, v, 0, (dem_real)radius);
    dem_step_advice_get(world, &advice);
    desc.dt = (dem_real)(frac*(double)advice.dt_max);
    dem_world_destroy(world);
    world = dem_world_create(&desc);
    stuff = dem_material_add(world, &m);
    dem_spheres_add(world, stuff, 256, x, v, 0, (dem_real)radius);
    result = dem_world_step(world, 300);
    for (i = 0; i < 256; i++) {
        const dem_real *u = dem_bodies_get(world).velocities + 4*i;
        fastest = fmax(fastest, fabs((double)u[0]) + fabs((double)u[1]) + fabs((double)u[2]));
    }
    dem_world_destroy(world);
    if (result == DEM_ERROR_TIME_STEP) return -1;
    return result == DEM_OK ? fastest/3e-4 : 1e30;
}

/* A ball pressed between `planes` planes by 2 % of its radius, or a close packing of balls pressed by
   as much, shaken a little (m/s). allow: as in the desc. Linear springs. */
enum { HELD_CRYSTAL = 0 };
static dem_world *held_world(int planes, double dt, int allow) {
    static const double n[6][3] = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
    const double radius = 1e-3, a = 2*radius*0.99*sqrt(2.0), shake = DEMI_SINGLE ? 1e-4 : 1e-7;
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc m = scene_stuff(1e7, planes ? 0.5 : 1, 0.5, planes ? 1 : 0);
    dem_material stuff;
    dem_world *world;
    uint64_t seed = 7;
    int i, j;
    desc.threads = 1;
    desc.dt = (dem_real)dt;
    desc.allow_large_dt = allow;
    desc.normal_law = DEM_NORMAL_LINEAR;
    m.stiffness = 1e4;
    desc.domain = box_of(0, 0, 0, 3*a, 3*a, 3*a);
    for (i = 0; i < 3 && !planes; i++) desc.boundary[i] = DEM_BOUNDARY_PERIODIC;
    world = dem_world_create(&desc);
    stuff = dem_material_add(world, &m);
    for (i = 0; i < planes; i++)
        dem_wall_plane_add(world, stuff, at(-0.98*radius*n[i][0], -0.98*radius*n[i][1], -0.98*radius*n[i][2]),
                      at(n[i][0], n[i][1], n[i][2]));
    for (i = 0; i < (planes ? 1 : 27); i++)
        for (j = 0; j < (planes ? 1 : 4); j++) {
            const double x = i%3 + (j == 1 || j == 2 ? 0.5 : 0), y = i/3%3 + (j == 1 || j == 3 ? 0.5 : 0);
            const double z = i/9 + (j == 2 || j == 3 ? 0.5 : 0);
            const dem_body body = dem_sphere_add(world, stuff, (dem_real)radius, at(x*a, y*a, z*a));
            const dem_vec3 v = scene_at(&seed, 2*shake, -shake, 2*shake, -shake, 2*shake, -shake);
            scene_move(world, body, v, at(1e3*(double)v.y, 1e3*(double)v.z, 1e3*(double)v.x));
        }
    return world;
}
/* The largest dt that is accepted, s. */
static double held_limit(int planes) {
    dem_world *world = held_world(planes, 1e-9, 1);
    double limit;
    CHECK_EQ(dem_world_step(world, 1), DEM_OK);
    CHECK_EQ(demi_press_limit(world, 1), DEM_OK);
    limit = world->pressed.least;
    CHECK(limit < 1);
    CHECK(world->pressed.worst < world->bodies.count);
    dem_world_destroy(world);
    return limit;
}
/* By how much the fastest is faster after `steps` of dt than at first. */
static double held_growth(int planes, double dt, int steps) {
    dem_world *world = held_world(planes, dt, 1);
    double before = 0, after = 0;
    int i, k;
    for (k = 0; k < 2; k++) {
        double most = 0;
        for (i = 0; i < world->bodies.count; i++) {
            const dem_body_state s = scene_state(world, dem_body_id_get(world, i));
            most = fmax(most, fmax((double)demi_length(s.velocity), 1e-3*(double)demi_length(s.spin)));
        }
        if (k) after = most; else before = most;
        if (!k) CHECK_EQ(dem_world_step(world, (uint64_t)steps), DEM_OK);
    }
    dem_world_destroy(world);
    return after/before;
}
/* A ball of 1 mm in a tube along y, pressed in by 4 %: of triangles of 0.25 mm, or a cylinder. Answers
   the step that what presses allows, s; *result: of a step of t_c/50. */
static double tube_limit(int fine, dem_result *result) {
    enum { AROUND = 24, ALONG = 16 };
    static dem_real x[3*(AROUND + 1)*(ALONG + 1)];
    static int32_t corners[6*AROUND*ALONG];
    const double radius = 1e-3, R = 1.9e-3;
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_advice advice;
    double limit = 0;
    int given, i, j, n = 0;
    for (i = 0; i <= AROUND; i++)
        for (j = 0; j <= ALONG; j++) {
            const double angle = (i - AROUND/2)*0.25e-3/R;
            x[3*((ALONG + 1)*i + j)] = (dem_real)(R*sin(angle));
            x[3*((ALONG + 1)*i + j) + 1] = (dem_real)((j - ALONG/2)*0.25e-3);
            x[3*((ALONG + 1)*i + j) + 2] = (dem_real)(-R*cos(angle));
            if (i == AROUND || j == ALONG) continue;
            corners[n++] = (ALONG + 1)*i + j;
            corners[n++] = (ALONG + 1)*(i + 1) + j;
            corners[n++] = (ALONG + 1)*(i + 1) + j + 1;
            corners[n++] = (ALONG + 1)*i + j;
            corners[n++] = (ALONG + 1)*(i + 1) + j + 1;
            corners[n++] = (ALONG + 1)*i + j + 1;
        }
    desc.threads = 1;
    desc.normal_law = DEM_NORMAL_LINEAR;
    for (given = 0; given < 2; given++) {       /* the step that is advised; then that, given */
        dem_world *world = dem_world_create(&desc);
        dem_material_desc m = scene_stuff(1e7, 0.3, 0.5, 0);
        dem_material stuff;
        dem_mesh mesh;
        m.stiffness = 1e4;
        stuff = dem_material_add(world, &m);
        mesh.vertex_count = (AROUND + 1)*(ALONG + 1);
        mesh.vertices = x;
        mesh.triangle_count = 2*AROUND*ALONG;
        mesh.triangles = corners;
        if (fine) dem_wall_mesh_add(world, stuff, &mesh);
        else dem_wall_cylinder_add(world, stuff, at(0, 0, 0), at(0, 1, 0), (dem_real)R, 1);
        dem_sphere_add(world, stuff, (dem_real)radius, at(0, 1e-5, -(R - 0.96*radius)));
        CHECK_EQ(dem_step_advice_get(world, &advice), DEM_OK);
        desc.dt = (dem_real)(0.999*(double)advice.contact_time/50);
        *result = dem_world_step(world, 1);
        if (given) {
            CHECK_EQ(demi_press_limit(world, 1), DEM_OK);
            limit = world->pressed.least;
        }
        dem_world_destroy(world);
    }
    return limit;
}

/* A magnet of moment MU (A m2) along its own x in a field B (T) along the world's x. */
enum { MAGNET = 3 };                            /* MU B = 3 N m */
static void compass(const dem_body_state *body, dem_body id, double time, dem_vec3 *force,
                    dem_vec3 *torque, void *user) {
    const dem_vec3 x = dem_quat_rotate(body->orientation, at(1, 0, 0));
    (void)id; (void)time; (void)force; (void)user;
    torque->y = x.z*MAGNET;                     /* MU x B */
    torque->z = -x.y*MAGNET;
}
/* A torque in proportion to the time, on the body that `user` names. */
static void spin_up(const dem_body_state *body, dem_body id, double time, dem_vec3 *force,
                    dem_vec3 *torque, void *user) {
    const dem_body *who = (const dem_body *)user;
    if (who->slot != id.slot || who->generation != id.generation) return;
    torque->z = (dem_real)(2*time)*body->inertia;
    force->x = 3*body->mass;
}

/* --- the built-in laws, called by one of the user's --- */
static void hertz_spring_epsd(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    dem_law_hertz(c, memory, f);
    dem_law_spring(c, memory, f);
    dem_law_roll_epsd(c, memory + 3, f);
}
static void linear_rescaled(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    dem_law_linear(c, memory, f);
    dem_law_mindlin_rescaled(c, memory, f);
}
/* Grains that fall and roll on a slope for 400 steps: ledger, positions and spins summed into one number. */
static uint64_t slope_of(dem_law_fn law, dem_normal_law normal, dem_tangent_law tangent,
                         int rolling, int mixed) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material stuff;
    dem_bodies b;
    dem_ledger book;
    uint64_t sum = 0;
    int i;
    desc.gravity = at(3, 0, -9.81);
    desc.threads = 1;
    desc.dt = DEM_R(1e-6);
    desc.normal_law = normal;
    desc.tangent_law = tangent;
    desc.ledger = 1;
    desc.law = law;
    desc.law_memory = law ? 6 : 0;
    desc.law_vectors = law ? law == hertz_spring_epsd ? 2 : 1 : 0;
    desc.law_stiffness = law ? DEM_R(1e5) : 0;
    world = dem_world_create(&desc);
    stuff = scene_material(world, 1e7, 0.6, 0.4, rolling ? 0.05 : 0);
    dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1));
    scene_block(world, stuff, 5, 5, 4, 1e-3, mixed, 1, 11);
    CHECK_EQ(scene_step(world, 400), DEM_OK);
    CHECK(dem_counters_get(world).contacts > 0);
    book = dem_ledger_get(world);
    CHECK(book.elastic > 0 && book.normal > 0 && book.slide > 0);
    sum = demi_hash(sum, &book, sizeof book);
    b = dem_bodies_get(world);
    for (i = 0; i < 4*b.count; i++) {
        sum = demi_hash(sum, b.positions + i, sizeof(dem_real));
        sum = demi_hash(sum, b.spins + i, sizeof(dem_real));
    }
    dem_world_destroy(world);
    return sum;
}

/* How a cluster of three spheres moves that has fallen, spinning, onto a plane, beside as many more as asked for. */
static uint64_t lonely_fall(dem_normal_law normal, dem_tangent_law tangent, dem_rolling_law rolling, int ledger,
                            int more) {
    const dem_real x[9] = {0, 0, 0, DEM_R(1.2e-3), 0, 0, 0, DEM_R(1.2e-3), 0};
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc m = scene_stuff(1e7, 0.6, 0.4, 0.05);
    dem_cluster_desc c = DEM_CLUSTER_DESC;
    dem_world *world;
    dem_material stuff;
    dem_body_state s;
    dem_body first;
    dem_shape shape;
    uint64_t sum = 0;
    int i;
    desc.gravity = at(3, 0, -9.81);
    desc.threads = 1;
    desc.dt = DEM_R(1e-6);
    desc.normal_law = normal;
    desc.tangent_law = tangent;
    desc.rolling_law = rolling;
    desc.ledger = ledger;
    world = dem_world_create(&desc);
    m.stiffness = normal == DEM_NORMAL_HERTZ ? 0 : 1000;
    m.stiffness_unloading = normal == DEM_NORMAL_HYSTERETIC ? 2000 : 0;
    if (normal == DEM_NORMAL_HYSTERETIC) m.restitution = 0;
    stuff = dem_material_add(world, &m);
    dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1));
    c.count = 3;
    c.positions = x;
    c.radius = DEM_R(1e-3);
    shape = dem_shape_cluster_add(world, &c);
    for (i = 0; i <= more; i++) {
        const dem_body body = dem_body_add(world, stuff, shape, at(0.02*i, 0, 1e-3), dem_quat_make(1, 0, 0, 0));
        if (!i) first = body;
        scene_move(world, body, at(0.3, 0.1, -0.2 - 0.01*i), at(5, 11 + i, 30));
    }
    CHECK_EQ(scene_step(world, 300), DEM_OK);
    s = scene_state(world, first);
    sum = demi_hash(sum, &s.position, sizeof s.position);
    sum = demi_hash(sum, &s.orientation, sizeof s.orientation);
    sum = demi_hash(sum, &s.velocity, sizeof s.velocity);
    sum = demi_hash(sum, &s.spin, sizeof s.spin);
    CHECK(s.velocity.z > DEM_R(-0.19));         /* it has touched */
    dem_world_destroy(world);
    return sum;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    /* Two digits of the order, from errors at 400 and 800 steps against 12800: 1.8 leaves room for
       what is left of higher orders. Single precision sees its own round-off instead. */
    TEST("a user-defined law that calls built-in ones gives their bits and their ledger, between grains and on walls") {
        int mixed;
        for (mixed = 0; mixed < 2; mixed++) {
            CHECK_EQ(slope_of(hertz_spring_epsd, DEM_NORMAL_HERTZ, DEM_TANGENT_SPRING, 1, mixed),
                     slope_of(0, DEM_NORMAL_HERTZ, DEM_TANGENT_SPRING, 1, mixed));
            CHECK_EQ(slope_of(linear_rescaled, DEM_NORMAL_LINEAR, DEM_TANGENT_MINDLIN_RESCALED, 0,
                              mixed),
                     slope_of(0, DEM_NORMAL_LINEAR, DEM_TANGENT_MINDLIN_RESCALED, 0, mixed));
        }
    }
    TEST("a contact has the same bits alone and among many, for every law, with a ledger and without") {
        int normal, tangent, rolling, ledger;
        for (normal = DEM_NORMAL_HERTZ; normal <= DEM_NORMAL_HYSTERETIC; normal++)
            for (tangent = DEM_TANGENT_NONE; tangent <= DEM_TANGENT_MINDLIN_RESCALED; tangent++)
                for (rolling = DEM_ROLLING_NONE; rolling <= DEM_ROLLING_EPSD; rolling++)
                    for (ledger = 0; ledger < 2; ledger++) {
                        const dem_normal_law n = (dem_normal_law)normal;
                        const dem_tangent_law t = (dem_tangent_law)tangent;
                        const dem_rolling_law r = (dem_rolling_law)rolling;
                        const uint64_t alone = lonely_fall(n, t, r, ledger, 0);
                        CHECK_EQ(lonely_fall(n, t, r, ledger, 6), alone);
                        CHECK_EQ(lonely_fall(n, t, r, ledger, 40), alone);
                    }
    }
    TEST("each law's table row matches its constant, and its memory fits") {
        static const demi_law_row *const tables[] = {demi_normal_laws, demi_tangent_laws,
                                                     demi_rolling_laws};
        int k, i, most = 0;
        for (k = 0; k < 3; k++) {
            int own = 0;
            for (i = 0; tables[k][i].kind >= 0; i++) {
                CHECK_EQ(tables[k][i].kind, i);
                CHECK(tables[k][i].name && *tables[k][i].name);
                CHECK(3*tables[k][i].vectors <= tables[k][i].memory);
                own = DEMI_MAX(own, tables[k][i].memory);
            }
            CHECK(i >= 3);
            most += own;
        }
        CHECK(most <= DEMI_MEMORY);
    }
    TEST("tangential and rolling springs are integrated to second order in the time step, for every law") {
        static const dem_normal_law normal[] = {DEM_NORMAL_HERTZ, DEM_NORMAL_LINEAR,
                                                DEM_NORMAL_HYSTERETIC};
        int i, law;
        for (i = 0; i < 3 && small < 1; i++) {
            for (law = DEM_TANGENT_SPRING; law <= DEM_TANGENT_MINDLIN_RESCALED; law++)
                CHECK(order_of(swing_make(normal[i], (dem_tangent_law)law, DEM_ROLLING_NONE)) >
                      1.8);
            CHECK(order_of(swing_make(normal[i], DEM_TANGENT_NONE, DEM_ROLLING_EPSD)) > 1.8);
        }
    }
    TEST("a constant rolling torque that can hold a ball on a slope holds it, whatever the step") {
        CHECK_NEAR(creep(DEM_ROLLING_CONSTANT, 2e-5), 0, 1e-9 + 1e-4*small);
        CHECK_NEAR(creep(DEM_ROLLING_CONSTANT, 1e-5), 0, 1e-9 + 1e-4*small);
        CHECK_NEAR(creep(DEM_ROLLING_EPSD, 1e-5), 0, 1e-6 + 1e-4*small);  /* its swing dies out */
    }
    TEST("in an impact that slides throughout, friction's impulse is mu times the normal impulse under elastic load") {
        static const double e[] = {0.1, 0.25, 0.5, 0.75, 0.9, 1};
        int i;
        for (i = 0; i < 6; i++) {    /* ends of a contact fall within a step: 1 in about 1000 */
            CHECK_NEAR(friction_share(e[i], DEM_NORMAL_HERTZ), 1, 4e-3);
            CHECK_NEAR(friction_share(e[i], DEM_NORMAL_LINEAR), 1, 4e-3);
        }
    }
    TEST("an accepted time step is stable for grains pressed by twelve contacts") {
        static const double depth[] = {1e-4, 1e-3, 0.01, 0.05};
        int i;
        for (i = 0; i < 4; i++) {
            /* refused by name (-1), or run without growing; never run and blow up */
            CHECK(pressed(depth[i], 0.99) < 3);
            CHECK(pressed(depth[i], 0) >= 0);                /* dt = 0: chosen, and always right */
            CHECK(pressed(depth[i], 0) < 3);
        }
    }
    TEST("a step just inside the limit of pressed contacts is stable; one 5 % outside oscillates") {
        static const int planes[] = {HELD_CRYSTAL, 2, 3, 4, 5, 6};
        int i;
        for (i = 0; i < 6; i++) {
            const double limit = held_limit(planes[i]);
            dem_world *world = held_world(planes[i], 1.001*limit, 0);
            CHECK_EQ(dem_world_step(world, 1), DEM_ERROR_TIME_STEP);
            if (planes[i] > 2) CHECK_STR(dem_world_error_get(world), "body 1 is pressed by");
            dem_world_destroy(world);
            /* with dashpots motion dies out; without, it keeps the energy it began with: springs at
               their longest hold it all, and it wanders from body to body */
            CHECK(held_growth(planes[i], 0.98*limit, 2000) < (planes[i] ? 1 : 5));
            /* in single precision motion begins where contacts end and friction gives way */
            if (!DEMI_SINGLE) CHECK(held_growth(planes[i], 1.05*limit, 200) > 20);
        }
    }
    TEST("the report says what keeps a chosen step below t_c/50, and by how much") {
        dem_world *world = held_world(6, 0, 0);
        CHECK_EQ(dem_world_step(world, 1), DEM_OK);
        scene_report_has(world, "times shorter than t_c/50 = ");
        scene_report_has(world, "body 1, pressed by 6 contacts, is stable to");
        dem_world_destroy(world);
    }
    TEST("fine facets of a tube press a ball as one contact: t_c/50 passes, and the limit is a cylinder's") {
        dem_result smooth, fine;
        const double one = tube_limit(0, &smooth), many = tube_limit(1, &fine);
        CHECK_EQ(smooth, DEM_OK);
        CHECK_EQ(fine, DEM_OK);
        CHECK_REL(many, one, 0.05);             /* facets meet at 0.13 rad: their valley holds a little more */
    }
    TEST("a pair damped beyond the critical rate has a contact time that its dashpot resolves") {
        static const double share[] = {0.5, 1.5, 3, 30};      /* of sqrt(k m), the pair's mass */
        int i;
        for (i = 0; i < 4; i++) {
            const double radius = 1e-3, k = 1e4, mass = 2500*4.0/3*pi*radius*radius*radius/2;
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_material_desc m = scene_stuff(1e8, 0.5, 0, 0);
            dem_material stuff;
            dem_world *world;
            dem_pair pair;
            dem_advice a;
            dem_body ball[2];
            desc.threads = 1;
            desc.normal_law = DEM_NORMAL_LINEAR;
            m.stiffness = (dem_real)k;
            world = dem_world_create(&desc);
            stuff = dem_material_add(world, &m);
            dem_pair_get(world, stuff, stuff, &pair);
            pair.normal_damping = (dem_real)(share[i]*sqrt(k*mass));
            dem_pair_set(world, stuff, stuff, &pair);
            ball[0] = dem_sphere_add(world, stuff, (dem_real)radius, at(0, 0, 0));
            ball[1] = dem_sphere_add(world, stuff, (dem_real)radius, at(0, 0, 2.001*radius));
            scene_move(world, ball[1], at(0, 0, -1), at(0, 0, 0));
            CHECK_EQ(dem_step_advice_get(world, &a), DEM_OK);
            CHECK((double)a.contact_time <= 1.5*pi*sqrt(mass/k));
            /* velocity Verlet's limit */
            CHECK((double)a.dt_max*(double)pair.normal_damping/mass < 1);
            CHECK_EQ(dem_world_step(world, 2000), DEM_OK);
            CHECK(fabs((double)scene_state(world, ball[1]).velocity.z) <= 1 + 1e-6);
            dem_world_destroy(world);
        }
    }
    TEST("a chosen time step accounts for the speed that walls will reach, also before they move") {
        int kind;
        for (kind = DEM_MOTION_TRANSLATING; kind <= DEM_MOTION_OSCILLATING; kind++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_motion motion = DEM_MOTION;
            dem_world *world = dem_world_create(&desc);
            const dem_material m = scene_material(world, 1e7, 0.5, 0, 0);
            const dem_wall wall = scene_floor(world, m, 0, 0, 0.02, 0.02, 2, 2);
            dem_advice a;
            dem_sphere_add(world, m, DEM_R(1e-3), at(0, 0, 0.01));
            motion.kind = (dem_motion_kind)kind;
            motion.velocity = at(0, 0, 30);     /* m/s, or a direction */
            motion.axis = at(1, 0, 0);
            motion.speed = 1500;                /* 30 m/s at 0.02 m */
            motion.amplitude = DEM_R(0.01);
            motion.frequency = DEM_R(477.5);    /* 30 m/s as it passes the middle */
            motion.phase = DEM_R(1.5707963);    /* where it rests */
            CHECK_EQ(dem_wall_motion_set(world, wall, &motion), DEM_OK);
            CHECK_EQ(dem_step_advice_get(world, &a), DEM_OK);
            CHECK((double)a.speed > 29.9 && (double)a.speed < 50);
            dem_world_destroy(world);
        }
    }
    TEST("a grain that would pass through a wall or grain within one step stops the run with its name") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_material_desc m = scene_stuff(1e8, 0.5, 0.3, 0);
        dem_material stuff;
        dem_world *world;
        dem_body ball;
        int late;
        for (late = 0; late < 2; late++) {      /* fast from the start; speeded up on the way */
            dem_result result;
            desc.threads = 1;
            desc.normal_law = DEM_NORMAL_LINEAR;
            desc.dt = DEM_R(7.5e-6);
            desc.gravity = at(0, 0, late ? -3e7 : 0);
            desc.impact_speed = late ? 1 : 0;
            m.stiffness = DEM_R(100);
            world = dem_world_create(&desc);
            stuff = dem_material_add(world, &m);
            scene_floor(world, stuff, -0.01, -0.01, 0.01, 0.01, 2, 2);
            ball = dem_sphere_add(world, stuff, DEM_R(1e-3), at(0.001, 0.002, late ? 0.5 : 0.02));
            if (!late) scene_move(world, ball, at(0, 0, -5000), at(0, 0, 0));
            result = dem_world_step(world, 100);
            CHECK_EQ(result, DEM_ERROR_TIME_STEP);
            CHECK(strstr(dem_world_error_get(world), "m/s") != 0);
            CHECK((double)scene_state(world, ball).position.z > 0);
            dem_world_destroy(world);
        }
    }
    TEST("the time step accounts for the spring and the dashpot of rolling resistance") {
        static const double mu[] = {0.1, 1, 10, 100, 1e4};
        int i, k;
        for (i = 0; i < 5; i++) {
            double fastest = 0;
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_material stuff;
            dem_world *world;
            dem_body ball;
            desc.threads = 1;
            desc.gravity = at(0, 0, -9.81);
            desc.rolling_law = DEM_ROLLING_EPSD;
            world = dem_world_create(&desc);
            stuff = scene_material(world, 1e7, 0.5, 0.5, mu[i]);
            dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1));
            ball = dem_sphere_add(world, stuff, DEM_R(1e-3), at(0, 0, 1.2e-3));
            scene_move(world, ball, at(0.1, 0, 0), at(0, 10, 0));
            for (k = 0; k < 4000 && dem_world_step(world, 1) == DEM_OK; k++)
                fastest = fmax(fastest, fabs((double)scene_state(world, ball).spin.y));
            CHECK_EQ(k, 4000);
            CHECK(fastest < 82);        /* rolling without resistance: 10 2/7 + 100 5/7 rad/s */
            dem_world_destroy(world);
        }
    }

    TEST("[THO13]: damped oblique impacts without tension leave with the published slip and spin when the spring "
         "takes the limit") {
        int which;
        /* the width of the digitised points; the shared slider misses slip by 11 to 12 % */
        CHECK(slip_missed(DEM_NORMAL_LINEAR, DEM_TANGENT_SPRING, DEM_SLIDER_SPRING,
                          DEM_TENSION_COMPENSATED) < 5);
        CHECK(slip_missed(DEM_NORMAL_HERTZ, DEM_TANGENT_MINDLIN, DEM_SLIDER_SPRING,
                          DEM_TENSION_COMPENSATED) < 6);
        CHECK(slip_missed(DEM_NORMAL_LINEAR, DEM_TANGENT_SPRING, DEM_SLIDER_PARALLEL,
                          DEM_TENSION_COMPENSATED) > 8);
        for (which = 0; which < 4; which++)
            CHECK(spin_missed(DEM_SLIDER_SPRING, which) < 1.5);
    }
    TEST("without tension the restitution is as set, 0.05 to 1, and friction's impulse is mu times the normal "
         "impulse") {
        static const double e[] = {0.05, 0.1, 0.135335, 0.25, 0.5, 0.75, 0.9, 1};
        int i, normal;
        for (i = 0; i < 8; i++)
            for (normal = DEM_NORMAL_HERTZ; normal <= DEM_NORMAL_LINEAR; normal++) {
                const rebound r = oblique((dem_normal_law)normal, DEM_TANGENT_SPRING,
                                          DEM_SLIDER_PARALLEL, DEM_TENSION_COMPENSATED, DEM_LOAD_REPULSIVE, e[i],
                                          20, 4000);
                CHECK_NEAR(r.e, e[i], 2e-3);
                CHECK_NEAR(r.slip, 20 - 7*(1 + r.e)/(1 + e[i]), 0.02);
            }
    }
    TEST("friction's impulse keeps the bound of its load: elastic 1, repulsive 1.089, magnitude 1.177 at e = 0.25") {
        static const double bound[] = {1.0886, 1, 1.1772};       /* push, elastic, size */
        int load, normal;
        for (load = 0; load < 3; load++)
            for (normal = DEM_NORMAL_HERTZ; normal <= DEM_NORMAL_LINEAR; normal++) {
                const rebound r = oblique((dem_normal_law)normal, DEM_TANGENT_SPRING,
                                          DEM_SLIDER_PARALLEL, DEM_TENSION_ALLOWED, (dem_load)load, 0.25,
                                          20, 4000);
                CHECK_NEAR((20 - r.slip)/7*1.25/(1 + r.e), bound[load], 2e-3);
            }
    }
    TEST("a field that reads orientations rotates bodies: a compass needle swings with 2 pi sqrt(I/(mu B)), and the "
         "ledger closes") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_body needle;
        dem_body_state s;
        dem_ledger l;
        double period, angle, last, zero[2] = {0, 0}, before;
        int k, crossings = 0;
        desc.threads = 1;
        desc.ledger = 1;
        desc.dt = DEM_R(1e-4);
        desc.body_force = compass;
        world = dem_world_create(&desc);
        needle = dem_body_add(world, scene_material(world, 1e7, 0.5, 0, 0),
                              dem_shape_ellipsoid_add(world, at(0.1, 0.02, 0.03)), at(0, 0, 0),
                              dem_quat_about(at(0, 0, 1), DEM_R(0.05)));
        s = scene_state(world, needle);
        period = 2*pi*sqrt((double)s.moments.z/MAGNET);
        if ((double)s.moments.z < (double)s.moments.x) period = 0;       /* principal order */
        before = dem_totals_get(world).rotational;
        last = 0.05;
        for (k = 0; k < (int)(3*period/1e-4) && crossings < 2; k++) {
            dem_vec3 x;
            CHECK_EQ(scene_step(world, 1), DEM_OK);
            x = dem_quat_rotate(scene_state(world, needle).orientation, at(1, 0, 0));
            angle = atan2((double)x.y, (double)x.x);
            if ((angle < 0) != (last < 0))
                zero[crossings++] = (k + last/(last - angle))*1e-4;      /* between two steps */
            last = angle;
        }
        CHECK_EQ(crossings, 2);
        /* amplitude a lengthens it by a^2/16 = 1.6e-4 */
        CHECK_REL(2*(zero[1] - zero[0]), period*(1 + 0.05*0.05/16), small > 0 ? 1e-3 : 1e-5);
        l = dem_ledger_get(world);
        CHECK_NEAR((l.rotational - before - l.force)/(MAGNET*0.05*0.05/2), 0, small > 0 ? 1e-2 : 1e-3);
        dem_world_destroy(world);
    }
    TEST("a field's torque goes to the body it names, after sorting too, and to spheres") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material stuff;
        dem_body ball[50];
        int i;
        desc.threads = 1;
        desc.dt = DEM_R(1e-4);
        desc.body_force = spin_up;
        desc.force_user = &ball[17];
        world = dem_world_create(&desc);
        stuff = scene_material(world, 1e6, 0.5, 0, 0);
        for (i = 0; i < 50; i++)
            ball[i] = dem_sphere_add(world, stuff, DEM_R(0.01), at(-0.1*i, 0.05*(i%7), 0.1*(i%3)));
        CHECK_EQ(scene_step(world, 10000), DEM_OK);
        for (i = 0; i < 50; i++) {
            const dem_body_state s = scene_state(world, ball[i]);
            CHECK_NEAR(s.spin.z, i == 17 ? 1 : 0, 2e-3);           /* integral of 2 t; dt = .001 */
            CHECK_NEAR(s.velocity.x, i == 17 ? 3 : 0, small > 0 ? 1e-4 : 1e-9);
        }
        dem_world_destroy(world);
    }
    TEST("an effect set but absent in the scene costs nothing: the same stages, no memory, the same bits") {
        static const struct { dem_tangent_law tangent; dem_rolling_law rolling; double mu; int also; } sets[][2] = {
            {{DEM_TANGENT_NONE, DEM_ROLLING_NONE, 0, 0}, {DEM_TANGENT_SPRING, DEM_ROLLING_NONE, 0, 0}},
            {{DEM_TANGENT_NONE, DEM_ROLLING_NONE, 0, 0}, {DEM_TANGENT_MINDLIN_RESCALED, DEM_ROLLING_EPSD, 0, 0}},
            {{DEM_TANGENT_SPRING, DEM_ROLLING_NONE, 0.3, 0}, {DEM_TANGENT_SPRING, DEM_ROLLING_STEP, 0.3, 0}},
            {{DEM_TANGENT_SPRING, DEM_ROLLING_NONE, 0.3, 0}, {DEM_TANGENT_SPRING, DEM_ROLLING_CONSTANT, 0.3, 0}},
            {{DEM_TANGENT_SPRING, DEM_ROLLING_NONE, 0.3, 0}, {DEM_TANGENT_SPRING, DEM_ROLLING_EPSD, 0.3, 0}},
            {{DEM_TANGENT_SPRING, DEM_ROLLING_NONE, 0.3, 0}, {DEM_TANGENT_SPRING, DEM_ROLLING_NONE, 0.3, 1}}};
        size_t i;
        int k, e;
        for (i = 0; i < sizeof sets/sizeof *sets; i++) {
            demi_run run[2];
            uint64_t hash[2];
            int kept[2];
            for (k = 0; k < 2; k++) {
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_world *world;
                dem_material glass;
                desc.threads = 1;
                desc.tangent_law = sets[i][k].tangent;
                desc.rolling_law = sets[i][k].rolling;
                world = dem_world_create(&desc);
                glass = scene_material(world, 1e7, 0.8, sets[i][k].mu, 0);
                if (sets[i][k].also) {          /* a material that no grain has, a field and a feed that are over */
                    dem_field_desc field;
                    dem_feed_desc feed;
                    memset(&field, 0, sizeof field);
                    memset(&feed, 0, sizeof feed);
                    field.box = feed.box = box_of(0, 0, 0, 1e-3, 1e-3, 1e-3);
                    field.cells[0] = field.cells[1] = field.cells[2] = 2;
                    field.interval = 1e-9;
                    field.end = 1e-12;
                    feed.material = glass;
                    feed.class_count = 1;
                    feed.radius[0] = DEM_R(1e-3);
                    feed.amount[0] = 1;
                    feed.rate = 1e-9;
                    scene_material(world, 2e7, 0.5, 0.3, 0);
                    CHECK(dem_field_add(world, &field).id);
                    CHECK(dem_feed_add(world, &feed).id);
                }
                scene_block(world, glass, 5, 5, 5, 1e-3, 0, 0.5, 3);
                CHECK_EQ(scene_step(world, 60), DEM_OK);
                run[k] = demi_run_of(world, DEM_R(1e-6), 1);
                kept[k] = world->memory_stride;
                hash[k] = demi_hash(DEMI_HASH_START, world->bodies.pos,
                                    4*(size_t)world->bodies.count*sizeof(dem_real));
                CHECK(dem_counters_get(world).contacts > 50);
                dem_world_destroy(world);
            }
            for (e = 0; e < DEMI_STAGES; e++) CHECK(run[0].stage[e] == run[1].stage[e]);
            CHECK_EQ(run[1].turning, run[0].turning);
            CHECK_EQ(run[1].parting, run[0].parting);
            CHECK_EQ(run[1].following, run[0].following);
            CHECK_EQ(kept[1], kept[0]);
            CHECK_EQ(hash[1], hash[0]);
        }
    }

    TEST("a pair that dem_pair_set has set keeps its values when a material changes, also those that equal "
         "the mixture") {
        int k;
        for (k = 0; k < 2; k++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_world *world = dem_world_create(&desc);
            dem_material_desc m = scene_stuff(1e7, 0.5, 0.5, 0);
            const dem_material a = dem_material_add(world, &m), b = dem_material_add(world, &m);
            const double set = k ? 0.51 : 0.5;
            dem_pair pair;
            dem_pair_get(world, a, b, &pair);
            pair.friction = (dem_real)set;
            CHECK_EQ(dem_pair_set(world, a, b, &pair), DEM_OK);
            m.friction = DEM_R(0.9);
            CHECK_EQ(dem_material_set(world, a, &m), DEM_OK);
            dem_pair_get(world, a, b, &pair);
            CHECK_NEAR(pair.friction, (double)(dem_real)set, 0);
            dem_pair_get(world, a, a, &pair);          /* no call has set this one */
            CHECK_NEAR(pair.friction, (double)DEM_R(0.9), 1e-7);
            dem_world_destroy(world);
        }
    }
    return test_end();
}
