/* Single impacts against closed shapes and against published benchmarks.
     Chung & Ooi, Granul. Matter 13 (2011) 643: eight impact tests; figures digitised from them
     Hertz (1882): largest overlap, largest force, duration
     Schwager & Poeschel, Granul. Matter 9 (2007) 465: restitution when a contact may not pull
     MFiX DEM05: oblique impacts of a linear spring
   A rigid plane is a second material whose pair with the first has 1/E* = (1-nu^2)/E and
   1/G* = (2-nu)/G of the sphere alone. Spheres fly along x and down to z = 0; slip at the contact
   is v_x - R omega_y. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"

static const double pi = 3.14159265358979323846;

typedef struct stuff { double young, poisson, density; } stuff;
static const stuff glass = {48e9, 0.20, 2800};
static const stuff al_alloy_2 = {70e9, 0.30, 2699};            /* of tests 2, 4 to 7: they differ */
static const stuff al_alloy = {70e9, 0.33, 2700};
static const stuff al_oxide = {380e9, 0.23, 4000};
static const stuff cast_iron = {100e9, 0.25, 7000};
static const stuff steel = {208e9, 0.30, 7850};
static const stuff nylon = {2.5e9, 0.40, 1000};

typedef struct shot {                /* a sphere that touches a rigid plane at t = 0 */
    stuff of;
    double radius, restitution, friction;
    double normal, tangent, spin;    /* m/s towards the plane, m/s along x, rad/s about y */
    double stiffness, ratio;         /* N/m and kt/kn: linear law; 0: Hertz */
    dem_tension tension;
    dem_tangent_law law;
    double dashpot;                  /* factor on the tangential dashpot */
    int steps;                       /* per duration of an elastic contact */
} shot;
typedef struct outcome { double normal, tangent, spin, e, overlap, force, duration; } outcome;

static double hertz_overlap(double young_eff, double r_eff, double m_eff, double speed) {
    return pow(15*m_eff*speed*speed/(16*young_eff*sqrt(r_eff)), 0.4);
}
static double hertz_duration(double overlap, double speed) { return 2.94327518*overlap/speed; }
static double plane_modulus(stuff s) { return s.young/(1 - s.poisson*s.poisson); }
static double sphere_mass(stuff s, double r) { return s.density*4/3*pi*r*r*r; }

static dem_material material_of(dem_world *world, stuff s, double restitution, double friction) {
    dem_material_desc m = DEM_MATERIAL_DESC;
    m.density = (dem_real)s.density;
    m.young = (dem_real)s.young;
    m.poisson = (dem_real)s.poisson;
    m.restitution = (dem_real)restitution;
    m.friction = (dem_real)friction;
    return dem_material_add(world, &m);
}
static dem_body_state state_of(const dem_world *world, dem_body body) {
    dem_body_state s;
    memset(&s, 0, sizeof s);
    dem_body_get(world, body, &s);
    return s;
}
static void set_motion(dem_world *world, dem_body body, double vx, double vz, double spin_y) {
    dem_body_state s = state_of(world, body);
    s.velocity = dem_vec3_make((dem_real)vx, 0, (dem_real)vz);
    s.spin = dem_vec3_make(0, (dem_real)spin_y, 0);
    dem_body_set(world, body, &s);
}

/* One impact on the rigid plane, from first touch until the sphere is free again. */
static outcome fire(shot s) {
    const double m = sphere_mass(s.of, s.radius), young_eff = plane_modulus(s.of);
    const double elastic = s.stiffness > 0 ? pi*sqrt(m/s.stiffness)
        : hertz_duration(hertz_overlap(young_eff, s.radius, m, s.normal), s.normal);
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material grain, rigid;
    dem_pair pair;
    dem_body body;
    outcome out = {0, 0, 0, 0, 0, 0, 0};
    int i;
    desc.threads = 1;
    desc.normal_law = s.stiffness > 0 ? DEM_NORMAL_LINEAR : DEM_NORMAL_HERTZ;
    desc.tangent_law = s.law;
    desc.tension = s.tension;
    desc.dt = (dem_real)(elastic/s.steps);
    desc.allow_large_dt = 1;
    world = dem_world_create(&desc);
    grain = material_of(world, s.of, s.restitution, s.friction);
    rigid = material_of(world, s.of, s.restitution, s.friction);
    dem_pair_get(world, grain, rigid, &pair);
    pair.young_eff = (dem_real)young_eff;
    pair.shear_eff = (dem_real)(s.of.young/(2*(1 + s.of.poisson)*(2 - s.of.poisson)));
    pair.stiffness = (dem_real)s.stiffness;
    pair.tangent_damping = (dem_real)s.dashpot;
    if (s.ratio > 0) pair.stiffness_ratio = (dem_real)s.ratio;
    dem_pair_set(world, grain, rigid, &pair);
    dem_wall_plane_add(world, rigid, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
    body = dem_sphere_add(world, grain, (dem_real)s.radius,
                          dem_vec3_make(0, 0, (dem_real)s.radius));
    set_motion(world, body, s.tangent, -s.normal, s.spin);
    for (i = 0; i < 20*s.steps; i++) {
        dem_body_state now;
        double gap;
        if (dem_world_step(world, 1) != DEM_OK) { puts(dem_world_error_get(world)); break; }
        now = state_of(world, body);
        gap = (double)now.position.z - s.radius;
        if (-gap > out.overlap) out.overlap = -gap;
        if ((double)now.force.z > out.force) out.force = (double)now.force.z;
        if (gap > 0 || (s.tension == DEM_TENSION_CLIPPED && now.velocity.z > 0 &&
                        now.force.z <= 0)) {
            out.normal = (double)now.velocity.z;
            out.tangent = (double)now.velocity.x;
            out.spin = (double)now.spin.y;
            out.e = out.normal/s.normal;
            out.duration = (double)(i + 1)*(double)desc.dt - gap/out.normal;
            break;
        }
    }
    dem_world_destroy(world);
    return out;
}
static shot shot_make(stuff of, double radius, double restitution, double friction, double normal) {
    shot s;
    memset(&s, 0, sizeof s);
    s.of = of;
    s.radius = radius;
    s.restitution = restitution;
    s.friction = friction;
    s.normal = normal;
    s.dashpot = 1;
    s.steps = 400;
    return s;
}

/* Two spheres that touch at t = 0 and meet with `speed` between them. */
static outcome meet(stuff of, double radius, double speed, int steps) {
    const double m = sphere_mass(of, radius)/2, young_eff = plane_modulus(of)/2, r = radius/2;
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material grain;
    dem_body a, b;
    outcome out = {0, 0, 0, 0, 0, 0, 0};
    int i;
    desc.threads = 1;
    desc.dt = (dem_real)(hertz_duration(hertz_overlap(young_eff, r, m, speed), speed)/steps);
    desc.allow_large_dt = 1;
    world = dem_world_create(&desc);
    grain = material_of(world, of, 1, 0.35);
    a = dem_sphere_add(world, grain, (dem_real)radius, dem_vec3_make(0, 0, (dem_real)radius));
    b = dem_sphere_add(world, grain, (dem_real)radius, dem_vec3_make(0, 0, (dem_real)-radius));
    set_motion(world, a, 0, -speed/2, 0);
    set_motion(world, b, 0, speed/2, 0);
    for (i = 0; i < 3*steps; i++) {
        dem_body_state sa, sb;
        double gap;
        if (dem_world_step(world, 1) != DEM_OK) { puts(dem_world_error_get(world)); break; }
        sa = state_of(world, a);
        sb = state_of(world, b);
        gap = (double)(sa.position.z - sb.position.z) - 2*radius;
        if (-gap > out.overlap) out.overlap = -gap;
        if ((double)sa.force.z > out.force) out.force = (double)sa.force.z;
        if (gap > 0) {
            out.normal = (double)(sa.velocity.z - sb.velocity.z);
            out.e = out.normal/speed;
            out.duration = (double)(i + 1)*(double)desc.dt - gap/out.normal;
            break;
        }
    }
    dem_world_destroy(world);
    return out;
}

/* Against overlap (m), force (N) and duration (s) of an elastic Hertz contact. */
static void check_hertz(outcome o, double overlap, double force, double duration,
                        double tolerance) {
    CHECK_REL(o.overlap, overlap, tolerance);
    CHECK_REL(o.force, force, tolerance);
    CHECK_REL(o.duration, duration, tolerance);
    CHECK_REL(o.e, 1, tolerance);
}

/* Test 6: spin only in the plane of the impact; tangential restitution -slip'/slip */
static double spin_beta(stuff of, double s, dem_tangent_law law, double dashpot,
                        dem_tension tension, double *e) {
    shot hit = shot_make(of, 0.1, 0.5, 0.4, 0.2);
    outcome o;
    hit.tension = tension;
    hit.law = law;
    hit.dashpot = dashpot;
    hit.steps = 2000;
    hit.spin = 3.5*0.4*1.5*0.2/(s*0.1);
    o = fire(hit);
    *e = o.e;
    return -(o.tangent - 0.1*o.spin)/(-0.1*hit.spin);
}

/* The same by integrating overlap, its rate and the slip alone, without dem.h: small steps of first
   order. Slip obeys d(slip)/dt = 3.5 F_t/m. */
static double integrate_beta(stuff of, double s, int law, double dashpot) {
    const double r = 0.1, m = sphere_mass(of, r), young_eff = plane_modulus(of);
    const double shear_eff = of.young/(2*(1 + of.poisson)*(2 - of.poisson));
    const double beta = log(2.0)/sqrt(pi*pi + log(2.0)*log(2.0)), dash = 2*sqrt(5.0/6)*beta;
    const double kn = 4*young_eff*sqrt(r)/3, cn = dash*sqrt(1.5*kn*m);
    const double k = 8*shear_eff*sqrt(r), c = dashpot*dash*sqrt(k*m);
    const double dt = hertz_duration(hertz_overlap(young_eff, r, m, 0.2), 0.2)/20000;
    const double first = -3.5*0.4*1.5*0.2/s;
    double depth = 0, speed = 0.2, slip = first, spring = 0, kt_before = 0;
    for (;;) {
        double fn, ft, kt, ct, trial;
        depth += speed*dt;
        fn = kn*pow(depth, 1.5) + cn*pow(depth, 0.25)*speed;
        if (depth <= 0 || fn <= 0) return -slip/first;
        kt = k*sqrt(depth);
        ct = c*pow(depth, 0.25);
        /* the spring law holds a length, the Mindlin laws a force */
        if (law == DEM_TANGENT_SPRING) spring = spring/(kt_before > 0 ? kt_before : kt)*kt;
        else if (law == DEM_TANGENT_MINDLIN_RESCALED && kt < kt_before) spring *= kt/kt_before;
        trial = spring - (kt*dt + ct)*slip;
        ft = fabs(trial) > 0.4*fn ? (trial > 0 ? 0.4 : -0.4)*fn : trial;
        spring -= kt*dt*(spring - ft)/(kt*dt + ct);    /* what friction holds, both hold */
        kt_before = kt;
        speed -= fn/m*dt;
        slip += 3.5*ft/m*dt;
    }
}

/* Test 8: a spinning sphere of 0.1 m lands on one of 5 times the radius, 1000 times the density */
static outcome land_on_giant(double young_factor, double omega) {
    const stuff big = {70e9*young_factor, 0.33, 2.7e6};
    const double m = sphere_mass(al_alloy, 0.1);
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_body a, b;
    outcome out = {0, 0, 0, 0, 0, 0, 0};
    int i;
    desc.threads = 1;
    desc.tension = DEM_TENSION_CLIPPED;
    desc.dt = (dem_real)(hertz_duration(hertz_overlap(plane_modulus(al_alloy), 0.1, m, 0.2),
                                        0.2)/2000);
    desc.allow_large_dt = 1;
    world = dem_world_create(&desc);
    a = dem_sphere_add(world, material_of(world, al_alloy, 0.5, 0.4), DEM_R(0.1),
                       dem_vec3_make(0, 0, DEM_R(0.1)));
    b = dem_sphere_add(world, material_of(world, big, 0.5, 0.4), DEM_R(0.5),
                       dem_vec3_make(0, 0, DEM_R(-0.5)));
    set_motion(world, a, 0, -0.2, omega);
    for (i = 0; i < 20000; i++) {
        dem_body_state sa, sb;
        if (dem_world_step(world, 1) != DEM_OK) { puts(dem_world_error_get(world)); break; }
        sa = state_of(world, a);
        sb = state_of(world, b);
        if ((double)(sa.position.z - sb.position.z) < 0.6) continue;
        out.normal = (double)(sa.velocity.z - sb.velocity.z);
        out.tangent = (double)sa.velocity.x;
        out.spin = (double)sa.spin.y;
        out.e = out.normal/0.2;
        break;
    }
    dem_world_destroy(world);
    return out;
}

/* What the ledger cannot account for, over what was lost: spheres that meet at many phases of a step, in pairs or (wall)
   on a plane, with friction. */
static double ledger_left(dem_integrator scheme, int wall, double steps) {
    dem_advice advice;
    dem_ledger l;
    double dt = 0;
    int pass, i;
    memset(&l, 0, sizeof l);
    for (pass = 0; pass < 2; pass++) {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_material_desc m = DEM_MATERIAL_DESC;
        dem_material soft;
        dem_world *world;
        desc.ledger = 1;
        desc.threads = 1;
        desc.impact_speed = 1;
        desc.integrator = scheme;
        desc.dt = (dem_real)dt;
        world = dem_world_create(&desc);
        m.density = 2500;
        m.young = DEM_R(1e8);
        m.poisson = DEM_R(0.23);
        m.restitution = DEM_R(0.6);
        m.friction = DEM_R(0.3);
        soft = dem_material_add(world, &m);
        if (wall) dem_wall_plane_add(world, soft, dem_vec3_make(0, 0, 0), dem_vec3_make(1, 0, 0));
        for (i = 0; i < 300; i++) {             /* gaps of 0.1 to 0.2 mm, oblique */
            const double gap = 1e-4*(1 + (i*0.618033988749895 - floor(i*0.618033988749895)));
            const dem_real y = (dem_real)(wall ? 0 : 1.6e-3*(i*0.414213562373095 - floor(i*0.414213562373095)));
            const dem_real z = (dem_real)(0.01*i), x = (dem_real)(1e-3 + gap), r = DEM_R(1e-3), half = DEM_R(0.5);
            const dem_real at[6] = {x, y, z, -x, 0, z}, speed[6] = {-half, wall ? half/4 : 0, 0, half, 0, 0};
            dem_spheres_add(world, soft, wall ? 1 : 2, at, speed, 0, r);
        }
        if (!pass && dem_step_advice_get(world, &advice) == DEM_OK) dt = (double)advice.contact_time/steps;
        if (pass) {
            CHECK(dem_world_run(world, DEM_R(5e-3), 0, 0) == DEM_OK);
            l = dem_ledger_get(world);
            CHECK(l.normal > 0.2*l.throughput);
        }
        dem_world_destroy(world);
    }
    return l.residual/(l.normal + l.slide + l.tangent);
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    /* Tolerances of the Hertz tests: 1e-4 at tc/400 and 1e-3 at tc/50, what a second-order scheme
       shows; the largest value falls between two steps, which costs (pi/2n)^2/2 of it. */
    TEST("Chung & Ooi test 1: two glass spheres at 20 m/s reach Hertz's overlap, force and "
         "duration") {
        check_hertz(meet(glass, 0.01, 20, 400), 274.1127e-6, 10696.89, 40.33946e-6, 1e-4);
        check_hertz(meet(glass, 0.01, 20, 50), 274.1127e-6, 10696.89, 40.33946e-6, 1e-3);
    }
    TEST("Chung & Ooi test 2: an aluminium sphere on a rigid plane reaches Hertz's overlap, force "
         "and duration") {
        shot s = shot_make(al_alloy_2, 0.1, 1, 0, 0.2);
        check_hertz(fire(s), 49.71718e-6, 11369.86, 731.6566e-6, 1e-4);
        s.steps = 50;
        check_hertz(fire(s), 49.71718e-6, 11369.86, 731.6566e-6, 1e-3);
    }
    TEST("Chung & Ooi test 3: elastic impacts of aluminium oxide and cast iron are Hertz's") {
        shot s = shot_make(al_oxide, 2.5e-3, 1, 0, 3.9);
        s.steps = 50;
        check_hertz(fire(s), 8.08881e-6, 615.352, 6.10451e-6, 1e-3);
        s.of = cast_iron;
        check_hertz(fire(s), 17.18871e-6, 506.760, 12.97208e-6, 1e-3);
    }
    TEST("Chung & Ooi test 3: restitution comes out as it was set, for any material and speed") {
        static const double set[] = {0.2, 0.4, 0.6, 0.8, 1.0}, speed[] = {0.039, 0.39, 3.9, 39};
        size_t i, j, k;
        for (i = 0; i < 5; i++) for (j = 0; j < 4; j++) for (k = 0; k < 2; k++) {
            shot s = shot_make(k ? cast_iron : al_oxide, 2.5e-3, set[i], 0, speed[j]);
            CHECK_NEAR(fire(s).e, set[i], 1e-3); /* the published tolerance, at tc/400 */
        }
    }

    TEST("Chung & Ooi test 4: sliding impacts at 40 to 85 degrees give the rigid body's speed, "
         "spin and angle") {
        static const double rows[][4] = { /* degrees from the normal, v_t'/v_t, rad/s, degrees */
            {40, 0.78291, 544.22, 11.621}, {50, 0.84715, 456.65, 29.488},
            {60, 0.89483, 355.21, 48.159}, {70, 0.93370, 242.98, 65.086},
            {80, 0.96788, 123.36, 78.983}, {85, 0.98406, 61.92, 84.812}};
        static const dem_tangent_law laws[] = {DEM_TANGENT_SPRING, DEM_TANGENT_MINDLIN,
                                               DEM_TANGENT_MINDLIN_RESCALED};
        size_t i, j;
        for (i = 0; i < 6; i++) for (j = 0; j < 3; j++) {
            const double angle = rows[i][0]*pi/180, r = 2.5e-3;
            shot s = shot_make(al_oxide, r, 0.98, 0.092, 3.9*cos(angle));
            outcome o;
            double impulse; /* of friction over m, with the restitution as realised */
            s.tangent = 3.9*sin(angle);
            s.law = laws[j];
            o = fire(s);
            impulse = 0.092*(1 + o.e)*s.normal;
            CHECK_REL(o.e, 0.98, 1e-3);
            CHECK_REL(o.tangent, s.tangent - impulse, 1e-3);
            CHECK_REL(r*o.spin, 2.5*impulse, 1e-3);
            CHECK_REL(o.tangent/s.tangent, rows[i][1], 1e-3);
            CHECK_REL(o.spin, rows[i][2], 1e-3);
            CHECK_REL(atan2(o.tangent - r*o.spin, o.normal)*180/pi, rows[i][3], 1e-3);
        }
    }
    TEST("MFiX DEM05: oblique impacts of a linear spring give its tangential restitution from 5 to "
         "60 degrees") {
        /* degrees, converged solution, MFiX, share of MFiX allowed */
        static const double rows[][4] = {
            {5, 0.8064, 0.7981, 0.01}, {10, 0.6518, 0.6556, 0.01}, {15, 0.5941, 0.5971, 0.004},
            {20, 0.5931, 0.5946, 0.004}, {25, 0.6217, 0.6219, 5e-4}, {30, 0.6813, 0.6813, 5e-4},
            {45, 0.8160, 0.8160, 5e-4}, {60, 0.8938, 0.8938, 5e-4}};
        static const dem_tangent_law laws[] = {DEM_TANGENT_SPRING, DEM_TANGENT_MINDLIN};
        size_t i, j;
        for (i = 0; i < 8; i++) for (j = 0; j < 2; j++) {
            const double angle = rows[i][0]*pi/180;
            shot s = shot_make(al_oxide, 2.5e-3, 1, 0.092, 3.9*cos(angle));
            double e_t;
            s.tangent = 3.9*sin(angle);
            s.stiffness = 1.72e7;
            s.ratio = 1.48/1.72;
            s.law = laws[j];
            s.steps = 4000;                   /* the solution is the one for dt -> 0 */
            e_t = fire(s).tangent/s.tangent;
            CHECK_NEAR(e_t, rows[i][1], 5e-4);
            /* beyond 20 degrees 5e-4, and the rounding of the figure */
            CHECK_NEAR(e_t, rows[i][2], rows[i][3] < 0.001 ? 6e-4 : rows[i][3]);
        }
    }
    TEST("Chung & Ooi test 5: beyond x = 7 a steel sphere slides throughout, with spin 5 and slip x - 7 in units of "
         "mu v_n") {
        static const double x[] = {7, 8, 10, 15, 20};
        size_t i;
        for (i = 0; i < 5; i++) {
            const double unit = 0.3*5, r = 10e-6;
            shot s = shot_make(steel, r, 1, 0.3, 5);
            outcome o;
            s.tangent = x[i]*unit;
            o = fire(s);
            CHECK_REL(r*o.spin/unit, 5, 1e-4); /* e is 1 to the error of the scheme at tc/400 */
            CHECK_NEAR((o.tangent - r*o.spin)/unit, x[i] - 7, 1e-4*x[i]);
        }
    }

    TEST("Chung & Ooi test 6: a spinning sphere that slides throughout has beta = s - 1") {
        static const double s[] = {0.2, 0.3, 0.5, 0.7, 0.9};
        size_t i, k;
        for (i = 0; i < 5; i++) for (k = 0; k < 2; k++) {
            double e, beta = spin_beta(k ? nylon : al_alloy, s[i], DEM_TANGENT_SPRING, 1,
                                       DEM_TENSION_CLIPPED, &e);
            CHECK_NEAR(beta, s[i]*(1 + e)/1.5 - 1, 2e-3); /* s with the restitution as realised */
            /* tension kept: no friction while it pulls; until then came (1 + .550283) m v_n */
            beta = spin_beta(k ? nylon : al_alloy, s[i], DEM_TANGENT_SPRING, 1,
                             DEM_TENSION_ALLOWED, &e);
            CHECK_NEAR(e, 0.5, 1e-3);
            CHECK_NEAR(beta, s[i]*1.550283/1.5 - 1, 2e-3);
        }
    }
    /* The digitised curve depends on the tangential dashpot. With Mindlin's stiffness and the
       dashpot 2 sqrt(5/6) beta sqrt(8 G* sqrt(R) m) of the common codes it is met within the
       published band up to s = 4.5; at s = 7.8, 11.9 and 24 (-.208 -.258 -.342) such a law gives
       -.076 -.080 -.083, with half that dashpot -.152 -.193 -.220, with none at 24 -.327. No share
       of it meets every point. The next test is the exact one. */
    TEST("Chung & Ooi test 6: a sticking, spinning sphere reproduces the digitised beta(s) at s = 1.19 to 4.5") {
        static const double rows[][2] = {{1.19, 0.097}, {1.45, 0.119}, {1.74, 0.0996},
                                         {2.09, 0.058}, {3.0, -0.050}, {4.5, -0.140}};
        size_t i;
        double e;
        for (i = 0; i < 6; i++)
            CHECK_NEAR(spin_beta(al_alloy, rows[i][0], DEM_TANGENT_SPRING, 1, DEM_TENSION_CLIPPED,
                                 &e), rows[i][1], 0.08);
        CHECK_NEAR(spin_beta(nylon, 24, DEM_TANGENT_SPRING, 1, DEM_TENSION_CLIPPED, &e),
                   -0.1155, 0.08);
    }
    TEST("Chung & Ooi test 6: a sticking, spinning sphere leaves as the contact's own equations say, for every law") {
        static const double s[] = {1.19, 1.45, 1.74, 2.09, 3.0, 4.5, 7.8, 11.9, 24};
        size_t i;
        int law, half;
        double e;
        for (i = 0; i < 9; i++)
            for (law = DEM_TANGENT_SPRING; law <= DEM_TANGENT_MINDLIN_RESCALED; law++)
                /* without, with half and with the whole tangential dashpot */
                for (half = 0; half <= 2; half++) {
                    const stuff of = (i + (size_t)law) % 2 ? nylon : al_alloy;
                    const double beta = spin_beta(of, s[i], (dem_tangent_law)law, 0.5*half,
                                                  DEM_TENSION_CLIPPED, &e);
                    CHECK_NEAR(beta, integrate_beta(of, s[i], law, 0.5*half), 2e-3);
                }
    }
    TEST("Chung & Ooi test 8: landing on a sphere 5 times as large and 1000 times as dense equals landing on a plane") {
        static const double s[] = {0.2, 0.3, 0.5, 0.7};
        size_t i;
        for (i = 0; i < 4; i++) {
            const double omega = 4.2/s[i];    /* s = 3.5 mu (1 + e) v_n/(R omega) */
            shot plane = shot_make(al_alloy, 0.1, 0.5, 0.4, 0.2);
            outcome o, a = land_on_giant(1000, omega), b = land_on_giant(1, omega);
            plane.tension = DEM_TENSION_CLIPPED;
            plane.steps = 2000;
            plane.spin = omega;
            o = fire(plane);
            CHECK_REL(a.normal, o.normal, 1e-2);             /* the giant's mass and curvature */
            CHECK_REL(a.tangent, o.tangent, 1e-2);
            CHECK_REL(a.spin, o.spin, 1e-2);
            CHECK_REL(b.normal, o.normal, 1e-2);
            CHECK_REL(b.tangent, o.tangent, 1e-2);
            CHECK_REL(b.spin, o.spin, 1e-2);
        }
    }

    TEST("Schwager & Poeschel: with tension allowed restitution is as set, with tension clipped it follows their "
         "closed form") {
        static const double rows[][2] = {{0.98, 0.980081}, {0.9, 0.902026}, {0.8, 0.808099},
                                         {0.7, 0.718201}, {0.5, 0.550283}, {0.3, 0.397141},
                                         {0.1, 0.252729}};
        size_t i;
        int linear;
        for (i = 0; i < 7; i++) for (linear = 0; linear < 2; linear++) {
            shot s = shot_make(glass, 5e-3, rows[i][0], 0, 1);
            s.stiffness = linear ? 1e6 : 0;
            s.steps = 20000; /* closed shapes are for dt -> 0: first order at the ends */
            CHECK_NEAR(fire(s).e, rows[i][0], 1e-4);
            s.tension = DEM_TENSION_CLIPPED;
            CHECK_NEAR(fire(s).e, rows[i][1], 1e-4);
        }
    }

    TEST("the ledger closes to 1/1000 of the loss at 25 steps per contact, and its error falls as dt^3") {
        /* dashpots and springs at predicted velocities: 6 in 1000, and the square. Phases differ, so that meetings in
           mid-step average out; single precision: round-off of 100 steps of 2e-4 of a radius. */
        static const dem_integrator schemes[] = {DEM_INTEGRATOR_VELOCITY_VERLET, DEM_INTEGRATOR_LEAPFROG, DEM_INTEGRATOR_POSITION_VERLET};
        int k, wall;
        for (k = 0; k < 3; k++) for (wall = 0; wall < 2; wall++) {
            const double coarse = ledger_left(schemes[k], wall, 25), fine = ledger_left(schemes[k], wall, 75);
            CHECK_NEAR(coarse, 0, DEMI_SINGLE ? 5e-3 : 1e-3);
            if (DEMI_SINGLE) continue;
            CHECK(fabs(fine) < fabs(coarse)/9 || fabs(fine) < 2e-5);
        }
    }
    return test_end();
}
