/* Closed shapes of mechanics, and the worked numbers of the two theses that dem.h reproduces:
     [MIL] tumbling mill on a GPU: Fig 5.23 and 5.24, drop test Fig 6.1
     [ALK07] tumbling screening machine, MOLDYN: eq 2.25 to 2.31 */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"

static const double pi = 3.14159265358979323846;

static dem_vec3 at(double x, double y, double z) {
    return dem_vec3_make((dem_real)x, (dem_real)y, (dem_real)z);
}
static dem_body_state state_of(const dem_world *world, dem_body body) {
    dem_body_state s;
    memset(&s, 0, sizeof s);
    dem_body_get(world, body, &s);
    return s;
}
static void set_velocity(dem_world *world, dem_body body, dem_vec3 velocity) {
    dem_body_state s = state_of(world, body);
    s.velocity = velocity;
    dem_body_set(world, body, &s);
}
static void step(dem_world *world, int steps) {
    if (dem_world_step(world, steps) != DEM_OK) puts(dem_world_error_get(world));
}
static double ball_mass(double density, double r) { return density*4/3*pi*r*r*r; }
static double damping(double e) { return -log(e)/sqrt(pi*pi + log(e)*log(e)); }

/* A ball of 1 cm and 2600 kg/m3 with a linear law, resting in a plane z = 0; contact time in s. */
static dem_material ball_stuff(dem_world *world, double contact_time, double restitution,
                               double friction) {
    dem_material_desc m = DEM_MATERIAL_DESC;
    m.density = 2600;
    m.young = DEM_R(1e7);
    m.poisson = DEM_R(0.25);
    m.restitution = (dem_real)restitution;
    m.friction = (dem_real)friction;
    m.stiffness = (dem_real)(ball_mass(2600, 0.01)*pi*pi/(contact_time*contact_time));
    return dem_material_add(world, &m);
}
static dem_world *linear_world(dem_vec3 gravity, double dt) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.threads = 1;
    desc.gravity = gravity;
    desc.dt = (dem_real)dt;
    desc.normal_law = DEM_NORMAL_LINEAR;
    desc.allow_large_dt = 1;
    return dem_world_create(&desc);
}

/* ---- rolling and sliding ---- */

typedef struct roll { double time, speed, way, last_speed; } roll; /* first three: when slip ends */
static roll slide_to_roll(double mu, double v0) {
    const double contact = 5e-4, dt = contact/50, r = 0.01, sink = 9.81*contact*contact/(pi*pi);
    dem_world *world = linear_world(at(0, 0, -9.81), dt);
    const dem_material m = ball_stuff(world, contact, 0.5, mu);
    const dem_body body = dem_sphere_add(world, m, (dem_real)r, at(0, 0, r - sink));
    double before = v0;
    roll out = {0, 0, 0, 0};
    dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
    set_velocity(world, body, at(v0, 0, 0));
    while (dem_world_time_get(world) < 0.5*v0/(mu*9.81)) {
        dem_body_state s;
        double slip;
        step(world, 1);
        s = state_of(world, body);
        slip = (double)s.velocity.x - r*(double)s.spin.y;
        if (slip <= 0 && out.time <= 0) {    /* slip falls linearly: where it crossed zero */
            const double late = slip/(slip - before)*dt;
            out.time = dem_world_time_get(world) - late;
            out.speed = (double)s.velocity.x + mu*9.81*late;
            out.way = (double)s.position.x - out.speed*late;
        }
        before = slip;
        out.last_speed = (double)s.velocity.x;
    }
    dem_world_destroy(world);
    return out;
}

/* m/s at the end; mean m/s2 */
typedef struct descent { double speed, rise, spin_rise, slip; } descent;
/* From rest down an incline, with gravity tilted; accelerations over the second half. */
static descent run_down(double degrees, double g, double mu, double seconds) {
    const double contact = 5e-4, dt = contact/50, r = 0.01, a = degrees*pi/180;
    const double sink = g*cos(a)*contact*contact/(pi*pi);
    dem_world *world = linear_world(at(g*sin(a), 0, -g*cos(a)), dt);
    const dem_material m = ball_stuff(world, contact, 0.5, mu);
    const dem_body body = dem_sphere_add(world, m, (dem_real)r, at(0, 0, r - sink));
    const int half = (int)(seconds/dt/2 + 0.5);
    dem_body_state first, last;
    descent out;
    dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
    step(world, half);
    first = state_of(world, body);
    step(world, half);
    last = state_of(world, body);
    out.speed = (double)last.velocity.x;
    out.rise = (double)(last.velocity.x - first.velocity.x)/(half*dt);
    out.spin_rise = r*(double)(last.spin.y - first.spin.y)/(half*dt);
    out.slip = (double)last.velocity.x - r*(double)last.spin.y;
    dem_world_destroy(world);
    return out;
}

/* ---- cradle ---- */

/* Balls in a row that just touch; the first comes with 1 m/s. Fills in their velocities after all
   parted. */
static void cradle(dem_normal_law law, double size, int count, double *out) {
    const double r = size/64, m = ball_mass(7800, r), young_eff = 1e9/(2*(1 - 0.09));
    const double hertz = 2.94327518*pow(15*(m/2)/(16*young_eff*sqrt(r/2)), 0.4);
    const double contact = law == DEM_NORMAL_HERTZ ? hertz : pi*sqrt(m/2/1e7);
    dem_material_desc stuff = DEM_MATERIAL_DESC;
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material material;
    dem_body ball[8];
    int i;
    desc.threads = 1;
    desc.normal_law = law;
    desc.dt = (dem_real)(contact/1000);
    stuff.density = 7800;
    stuff.young = DEM_R(1e9);
    stuff.poisson = DEM_R(0.3);
    stuff.restitution = 1;
    stuff.stiffness = DEM_R(1e7);
    world = dem_world_create(&desc);
    material = dem_material_add(world, &stuff);
    for (i = 0; i < count; i++)
        ball[i] = dem_sphere_add(world, material, (dem_real)r, at(2*r*i, 0, 0));
    set_velocity(world, ball[0], at(1, 0, 0));
    step(world, 20000);                      /* 20 contact times */
    for (i = 0; i < count; i++) {
        out[i] = (double)state_of(world, ball[i]).velocity.x;
        CHECK_NEAR(state_of(world, ball[i]).velocity.z, 0, 1e-15);
        CHECK(i == 0 || out[i] > out[i - 1]); /* all parted for good */
    }
    dem_world_destroy(world);
}

/* ---- [MIL] ---- */

static const double mill_radius = 1.5e-3, mill_dt = 1e-6;
static dem_material mill_glass(dem_world *world) { /* pp of Fig 5.24: shear modulus 26 GPa */
    dem_material_desc m = DEM_MATERIAL_DESC;
    m.density = 2500;
    m.young = DEM_R(2*(1 + 0.23)*26e9);
    m.poisson = DEM_R(0.23);
    m.restitution = DEM_R(0.66);
    m.friction = DEM_R(0.154);
    return dem_material_add(world, &m);
}
static dem_material mill_lining(dem_world *world) { /* ps: shear modulus .31 GPa */
    dem_material_desc m = DEM_MATERIAL_DESC;
    m.density = 950;
    m.young = DEM_R(2*(1 + 0.42)*0.31e9);
    m.poisson = DEM_R(0.42);
    m.restitution = DEM_R(0.55);
    m.friction = DEM_R(0.32);
    return dem_material_add(world, &m);
}
/* Glass against the lining as Fig 5.23 has it: the coefficients of ps, not mixed with those of glass. */
static void mill_pair(dem_world *world, dem_material glass, dem_material lining) {
    dem_pair pair;
    CHECK_EQ(dem_pair_get(world, glass, lining, &pair), DEM_OK);
    pair.restitution = DEM_R(0.55);
    CHECK_EQ(dem_pair_set(world, glass, lining, &pair), DEM_OK);
}
typedef struct drop { double e[3], aside, spin; } drop;
/* Three bounces of a glass bead dropped from rest, `height` above the floor; heights to the tops
   that the bead reaches at a step, as the thesis measured them. The standard floor is of glass; that
   of the thesis is its flat sheet, of the lining. */
static drop drop_bead(dem_convention convention, dem_integrator integrator, double dt,
                      double height) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material glass, sheet;
    dem_body bead;
    dem_body_state s;
    double top = height, before = 0;
    drop out = {{0, 0, 0}, 0, 0};
    int bounce = 0;
    desc.threads = 1;
    desc.gravity.y = DEM_R(-9.81);
    desc.convention = convention;
    desc.integrator = integrator;
    if (convention == DEM_CONVENTION_MILL) desc.tangent_law = DEM_TANGENT_STEP;
    desc.dt = (dem_real)dt;
    desc.allow_large_dt = 1;
    world = dem_world_create(&desc);
    glass = sheet = mill_glass(world);
    if (convention == DEM_CONVENTION_MILL) {
        sheet = mill_lining(world);
        mill_pair(world, glass, sheet);
    }
    dem_wall_plane_add(world, sheet, at(0, 0, 0), at(0, 1, 0));
    bead = dem_sphere_add(world, glass, (dem_real)mill_radius, at(0, mill_radius + height, 0));
    while (bounce < 3 && dem_world_time_get(world) < 1) {
        double v;
        step(world, 1);
        s = state_of(world, bead);
        v = (double)s.velocity.y;
        if (before > 0 && v <= 0 && (double)s.position.y > mill_radius) {
            const double now = (double)s.position.y - mill_radius;
            out.e[bounce++] = sqrt(now/top);
            top = now;
        }
        before = v;
        out.aside = fmax(out.aside, fabs((double)s.velocity.x) + fabs((double)s.velocity.z));
        out.spin = fmax(out.spin,
                        fabs((double)s.spin.x) + fabs((double)s.spin.y) + fabs((double)s.spin.z));
    }
    dem_world_destroy(world);
    return out;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("bouncing ball (MFiX DEM01): comes to rest after sqrt(2h/g)(1+e)/(1-e), heights fall as "
         "e^(2k)") {
        /* e, s for .5 m */
        static const double rows[][2] = {{0.5, 0.95783}, {0.8, 2.87348}, {0.9, 6.06623}};
        int i;
        for (i = 0; i < 3; i++) { /* Hertz: a linear dashpot sets in with a jump, and e scatters */
            const double e = rows[i][0], contact = 1e-4*rows[i][1], r = 0.01, v = sqrt(2*9.81*0.5);
            const double deep = contact*v/2.94327518, m_ball = ball_mass(2600, r);
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_material_desc stuff = DEM_MATERIAL_DESC;
            dem_world *world;
            dem_material m;
            dem_body body;
            double rest = 0;
            int bounce = 0, down = 1;
            desc.threads = 1;
            desc.gravity.z = DEM_R(-9.81);
            desc.dt = (dem_real)(contact/200);
            desc.allow_large_dt = 1;
            stuff.density = 2600;            /* hard: g t_c is .03 to .2 % of the speed */
            stuff.young = (dem_real)(2*15*m_ball*v*v/(16*sqrt(r)*pow(deep, 2.5)));
            stuff.restitution = (dem_real)e;
            world = dem_world_create(&desc);
            m = dem_material_add(world, &stuff);
            body = dem_sphere_add(world, m, (dem_real)r, at(0, 0, r + 0.5));
            dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
            while (dem_world_time_get(world) < 1.1*rows[i][1]) {
                dem_body_state s;
                double gap;
                step(world, 4);
                s = state_of(world, body);
                gap = (double)s.position.z - r;
                if (gap > 0) rest = dem_world_time_get(world);           /* of the last flight */
                if (s.velocity.z < 0) down = 1;
                if (gap > 0 && s.velocity.z > 0 && down && bounce < 4) {
                    const double up = (double)s.velocity.z;
                    bounce++;
                    CHECK_REL(gap + up*up/(2*9.81), 0.5*pow(e, 2*bounce), 1e-2);
                    down = 0;
                }
            }
            /* the limit of hard contacts */
            CHECK_REL(rest, sqrt(2*0.5/9.81)*(1 + e)/(1 - e), 1e-2);
            CHECK_REL(rest, rows[i][1], 1e-2);
            CHECK_EQ(bounce, 4);
            dem_world_destroy(world);
        }
    }
    TEST("MFiX DEM04: a sliding ball rolls after 2 v0/(7 mu g), at 5/7 v0, having gone 12 v0^2/(49 "
         "mu g)") {
        int i;
        for (i = 1; i <= 5; i++) {
            const double mu = 0.2*i, v0 = 0.5 + 0.3*i;
            const roll r = slide_to_roll(mu, v0);
            CHECK_REL(r.time, 2*v0/(7*mu*9.81), 1e-3);
            CHECK_REL(r.speed, 5*v0/7, 1e-3);
            CHECK_REL(r.way, 12*v0*v0/(49*mu*9.81), 1e-3);
            CHECK_REL(r.last_speed, 5*v0/7, 1e-3);
        }
    }
    TEST("incline: a sphere rolls at 5/7 g sin from mu = 2/7 tan(angle) on; below it slides at g(sin - mu cos)") {
        static const double rows[][2] = {{15, 0.07656}, {30, 0.16496}, {45, 0.28571}};
        int i;
        for (i = 0; i < 3; i++) {
            const double a = rows[i][0]*pi/180, g = 9.81, least = 2*tan(a)/7;
            descent d = run_down(rows[i][0], g, 1.02*least, 0.4);
            CHECK_NEAR(least, rows[i][1], 5e-6);
            CHECK_REL(d.rise, 5*g*sin(a)/7, 1e-3);
            CHECK_REL(d.spin_rise, 5*g*sin(a)/7, 1e-3);
            CHECK_NEAR(d.slip/d.speed, 0, 1e-3);
            d = run_down(rows[i][0], g, 0.98*least, 0.4);
            CHECK_REL(d.rise, g*(sin(a) - 0.98*least*cos(a)), 1e-3);
            CHECK_REL(d.spin_rise, 2.5*0.98*least*g*cos(a), 1e-3);
            CHECK(d.slip/d.speed > 0.02);
            d = run_down(rows[i][0], g, 0.5*least, 0.4);
            CHECK_REL(d.rise, g*(sin(a) - 0.5*least*cos(a)), 1e-3);
            CHECK_REL(d.spin_rise, 2.5*0.5*least*g*cos(a), 1e-3);
        }
    }
    TEST("MercuryDPM inclined plane: 15 degrees, mu 0.5: 1.81173 m/s after one second") {
        CHECK_REL(run_down(15, 9.8, 0.5, 1).speed, 1.81173, 1e-3);
    }
    TEST("Newton's cradle of touching balls: exact velocities for 3 and 5 balls, Hertz and linear, at any size") {
        static const double hertz_3[] = {-0.07095, 0.07640, 0.99455};
        static const double hertz_5[] = {-0.07109, -0.03027, -0.01446, 0.12704, 0.98878};
        static const double linear_3[] = {-0.13026, 0.15023, 0.98003};
        static const double linear_5[] = {-0.13228, -0.07533, -0.03101, 0.29622, 0.94240};
        double v[5];
        int i, size;
        for (size = 1; size <= 2; size++) {
            cradle(DEM_NORMAL_HERTZ, size, 3, v);
            for (i = 0; i < 3; i++) CHECK_NEAR(v[i], hertz_3[i], 1e-4);
            cradle(DEM_NORMAL_HERTZ, size, 5, v);
            for (i = 0; i < 5; i++) CHECK_NEAR(v[i], hertz_5[i], 1e-4);
            cradle(DEM_NORMAL_LINEAR, size, 3, v);
            for (i = 0; i < 3; i++) CHECK_NEAR(v[i], linear_3[i], 1e-4);
            cradle(DEM_NORMAL_LINEAR, size, 5, v);
            for (i = 0; i < 5; i++) CHECK_NEAR(v[i], linear_5[i], 1e-4);
        }
    }

    /* Two glass balls of .0383 g and .09 g, k = 7.36 N/m, c = 8.96e-4 N s/m. The thesis rounds in
       between: its numbers are met to their last digit, the exact ones to 1e-6. */
    TEST("screening machine thesis, eq 2.25 to 2.31: contact time 0.006 s, time step 3e-4 s, restitution 0.905") {
        const double ri = 1.5e-3, rj = 2e-3, mi = 3.83e-5, mj = 9e-5, m = mi*mj/(mi + mj);
        const double k = 7.36, c = 8.96e-4;
        const double eta = c/(2*m), w0 = sqrt(k/m), w = sqrt(w0*w0 - eta*eta), e = exp(-pi*eta/w);
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_material_desc stuff = DEM_MATERIAL_DESC;
        dem_coefficients f;
        dem_world *world;
        dem_material si, sj;
        dem_body a, b;
        int i, refused;
        for (refused = 1; refused >= 0; refused--) {
            desc.threads = 1;
            desc.normal_law = DEM_NORMAL_LINEAR;
            desc.dt = (dem_real)(refused ? 3.1e-4 : 0.006/2000);
            world = dem_world_create(&desc);
            stuff.restitution = (dem_real)e;
            stuff.stiffness = (dem_real)k;   /* equal stiffnesses: the pair's is the same */
            stuff.density = (dem_real)(mi/(4*pi*ri*ri*ri/3));
            si = dem_material_add(world, &stuff);
            stuff.density = (dem_real)(mj/(4*pi*rj*rj*rj/3));
            sj = dem_material_add(world, &stuff);
            CHECK_EQ(dem_coefficients_get(world, si, sj, (dem_real)ri, (dem_real)rj, &f), DEM_OK);
            CHECK_NEAR(f.m_eff, 2.69e-5, 0.005e-5);                   /* 2.25 */
            CHECK_REL(f.kn, k, 1e-6);
            CHECK_REL(f.cn, c, 1e-6);                                 /* damping from restitution */
            /* 2.26, with m rounded to 2.69 */
            CHECK_NEAR((double)f.cn/(2*(double)f.m_eff), 16.65, 0.03);
            CHECK_NEAR(sqrt((double)(f.kn/f.m_eff)), 523.07, 0.4);    /* 2.27 */
            CHECK_REL(f.contact_time, pi/w, 1e-6);
            CHECK_NEAR(f.contact_time, 0.006, 5e-5);                  /* 2.29 */
            CHECK_NEAR((double)f.contact_time/20, 3e-4, 0.05e-4);     /* 2.30 */
            CHECK_NEAR(e, 0.905, 5e-4);                               /* 2.31 */
            a = dem_sphere_add(world, si, (dem_real)ri, at(0, 0, 0));
            b = dem_sphere_add(world, sj, (dem_real)rj, at(ri + rj, 0, 0));
            set_velocity(world, a, at(1e-3, 0, 0));
            if (refused) {                   /* "a ratio of 1:20" */
                CHECK_EQ(dem_world_step(world, 1), DEM_ERROR_TIME_STEP);
                CHECK_STR(dem_world_error_get(world), "t_c/20");
            } else {
                double time = 0, parted = 0;
                for (i = 0; i < 4000 && parted <= 0; i++) {
                    const dem_body_state s = state_of(world, a), t = state_of(world, b);
                    const double gap = (double)(t.position.x - s.position.x) - ri - rj;
                    const double rate = (double)(t.velocity.x - s.velocity.x);
                    if (i == 0 || gap <= 0) { step(world, 1); continue; }
                    parted = rate;
                    time = dem_world_time_get(world) - gap/rate;
                }
                CHECK_REL(parted/1e-3, e, 1e-4);                      /* dt = tc/2000 */
                CHECK_REL(time, pi/w, 1e-3);
            }
            dem_world_destroy(world);
        }
    }

    /* Fig 5.23 holds what multiplies delta^(3/2), delta^(1/4) v, delta^(1/2) v and delta^(1/4) v,
       with E* = E and 8 G of one body. Its tangential force coefficients hold the time step 1e-6 s
       (delta_t = V_t dt). Between grains delta is half the overlap; dem.h folds that into the
       coefficients for the whole one: 2^(3/2), 2^(1/4), 2^(1/2) and 2^(1/4) take it out again.
       Against the shell delta is the whole overlap, R* = r/2 and m* = m/2. */
    TEST("tumbling mill thesis, Fig 5.23: the eight coefficients from the properties of Fig 5.24, "
         "to five digits") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material glass, lining;
        dem_coefficients c;
        desc.convention = DEM_CONVENTION_MILL;
        desc.tangent_law = DEM_TANGENT_STEP;
        world = dem_world_create(&desc);
        glass = mill_glass(world);
        CHECK_EQ(dem_coefficients_get(world, glass, glass, (dem_real)mill_radius,
                                      (dem_real)mill_radius, &c), DEM_OK);
        CHECK_REL((double)c.kn*pow(2, 1.5), 2335490000, 5e-6);        /* ppNormalForceCoeff */
        CHECK_REL((double)c.cn*pow(2, 0.25), 59.5637, 5e-6);          /* ppNormalDampingCoeff */
        CHECK_REL((double)c.kt*sqrt(2.0)*mill_dt, 5696.31, 5e-6);     /* ppTanForceCoeff */
        CHECK_REL((double)c.ct*pow(2, 0.25), 75.9528, 5e-6);          /* ppTanDampingCoeff */
        lining = mill_lining(world);
        mill_pair(world, glass, lining);
        CHECK_EQ(dem_coefficients_get(world, glass, lining, (dem_real)mill_radius, 0, &c), DEM_OK);
        CHECK_REL(c.kn, 32147700, 5e-6);                              /* psNormalForceCoeff */
        CHECK_REL(c.cn, 9.96332, 5e-6);                               /* psNormalDampingCoeff */
        CHECK_REL((double)c.kt*mill_dt, 67.9176, 5e-6);               /* psTanForceCoeff */
        CHECK_REL(c.ct, 11.8243, 5e-6);                               /* psTanDampingCoeff */
        dem_world_destroy(world);
    }
    TEST("rules of the mill: two grains of different materials touch alike, whichever comes first") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material glass, lining;
        dem_coefficients c, o;
        desc.convention = DEM_CONVENTION_MILL;
        world = dem_world_create(&desc);
        glass = mill_glass(world);
        lining = mill_lining(world);
        CHECK_EQ(dem_coefficients_get(world, glass, lining, DEM_R(1e-3), DEM_R(2e-3), &c), DEM_OK);
        CHECK_EQ(dem_coefficients_get(world, lining, glass, DEM_R(2e-3), DEM_R(1e-3), &o), DEM_OK);
        CHECK_REL(c.kn, o.kn, 1e-6);
        CHECK_REL(c.cn, o.cn, 1e-6);
        CHECK_REL(c.kt, o.kt, 1e-6);
        CHECK_REL(c.ct, o.ct, 1e-6);
        dem_world_destroy(world);
    }
    TEST("tumbling mill thesis, Fig 5.24 in the standard mode: Hertz, Mindlin and Tsuji with E*, "
         "G*, R*, m*") {
        const double r = mill_radius, m = ball_mass(2500, r);
        const double E1 = 63.96e9, nu1 = 0.23, G1 = 26e9, E2 = 0.8804e9, nu2 = 0.42, G2 = 0.31e9;
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material glass, lining;
        dem_coefficients c;
        dem_pair pair;
        int wall;
        world = dem_world_create(&desc);
        glass = mill_glass(world);
        lining = mill_lining(world);
        dem_pair_get(world, glass, lining, &pair);
        CHECK_REL(pair.restitution, sqrt(0.66*0.55), 1e-12);
        CHECK_REL(pair.friction, sqrt(0.154*0.32), 1e-12);
        for (wall = 0; wall < 2; wall++) {
            const double E = 1/((1 - nu1*nu1)/E1 + (wall ? (1 - nu2*nu2)/E2 : (1 - nu1*nu1)/E1));
            const double G = 1/((2 - nu1)/G1 + (wall ? (2 - nu2)/G2 : (2 - nu1)/G1));
            const double R = wall ? r : r/2, M = wall ? m : m/2, e = wall ? sqrt(0.66*0.55) : 0.66;
            const double dash = 2*sqrt(5.0/6)*damping(e);
            CHECK_EQ(dem_coefficients_get(world, glass, wall ? lining : glass, (dem_real)r,
                                          (dem_real)(wall ? 0 : r), &c), DEM_OK);
            CHECK_REL(c.r_eff, R, 1e-12);
            CHECK_REL(c.m_eff, M, 1e-12);
            CHECK_REL(c.damping_ratio, damping(e), 1e-12);
            CHECK_REL(c.kn, 4.0/3*E*sqrt(R), 1e-12);
            CHECK_REL(c.cn, dash*sqrt(2*E*sqrt(R)*M), 1e-12); /* normal stiffness 2 E* sqrt(R* d) */
            CHECK_REL(c.kt, 8*G*sqrt(R), 1e-12); /* tangential 8 G* sqrt(R* d) */
            CHECK_REL(c.ct, dash*sqrt(8*G*sqrt(R)*M), 1e-12);
        }
        dem_world_destroy(world);
        desc.normal_law = DEM_NORMAL_LINEAR;
        desc.impact_speed = DEM_R(0.7);
        world = dem_world_create(&desc);
        glass = mill_glass(world);
        dem_coefficients_get(world, glass, glass, (dem_real)r, (dem_real)r, &c);
        {
            const double E = E1/(2*(1 - nu1*nu1)), M = m/2, R = r/2;
            const double k = pow(320.0/81*M*0.49*pow(E, 4)*R*R, 0.2); /* Di Maio & Di Renzo 2004 */
            const double ratio = 2*(1 - nu1)/(2 - nu1);
            CHECK_REL(c.kn, k, 1e-12);
            CHECK_REL(c.cn, 2*damping(0.66)*sqrt(k*M), 1e-12);
            CHECK_REL(c.kt, ratio*k, 1e-12);
            CHECK_REL(c.ct, 2*damping(0.66)*sqrt(ratio*k*M), 1e-12);
        }
        dem_world_destroy(world);
    }

    TEST("tumbling mill thesis, Fig 6.1, standard mode: every bounce has the restitution set, 0.66") {
        static const double heights[] = {0.003, 0.005, 0.0075};
        int i, k;
        for (i = 0; i < 3; i++) {            /* dt about tc/90 */
            const drop d = drop_bead(DEM_CONVENTION_STANDARD, DEM_INTEGRATOR_VELOCITY_VERLET, 2e-7, heights[i]);
            for (k = 0; k < 3; k++) CHECK_NEAR(d.e[k], 0.66, 0.002);
            CHECK(d.aside <= 0);             /* exactly */
            CHECK(d.spin <= 0);
        }
    }
    /* On its flat sheet with the ps row of Fig 5.23: seven bounces are printed, .659 .658 .657 (Fig 6.1), .656 .656 .656
       (6.2), .656 (6.3). The drop is 5 mm: its plots reach .31 m/s. A contact lasts about 80 steps, and a bounce scatters
       by .0015 with the instant of first touch. The damping is that of restitution .55 for half of the bead's mass; for
       the whole mass the damping ratio is smaller by sqrt(2), which gives .6577 with small steps and without gravity. The
       thesis's text says forward Euler, but its kernels move the positions with the velocities just updated: symplectic
       Euler. */
    TEST("tumbling mill thesis, Fig 6.1 to 6.3: on its flat sheet a bead rebounds with 0.656 to 0.659") {
        double sum = 0, least = 1, most = 0;
        int i, k, count = 0;
        for (i = 0; i < 12; i++) {
            const drop d = drop_bead(DEM_CONVENTION_MILL, DEM_INTEGRATOR_SYMPLECTIC_EULER, mill_dt,
                                     0.005 + 3.1e-6*i);
            for (k = 0; k < 3; k++) {
                least = fmin(least, d.e[k]);
                most = fmax(most, d.e[k]);
                sum += d.e[k];
                count++;
            }
            CHECK(d.aside <= 0);
            CHECK(d.spin <= 0);
        }
        CHECK_NEAR(least, 0.656, 0.001);                   /* the last digit printed */
        CHECK_NEAR(most, 0.659, 0.001);
        CHECK_NEAR(sum/count, 0.6569, 0.0005);             /* mean of the seven, to their rounding */
        printf("    mill thesis, its flat sheet: restitution %.4f to %.4f, mean %.4f of %d bounces\n", least, most,
               sum/count, count);
    }
    TEST("tumbling mill thesis, Fig 6.1: with forward Euler, as in its text, a bead rebounds with 0.70 to 0.72") {
        int i, k;
        for (i = 0; i < 3; i++) {
            const drop d = drop_bead(DEM_CONVENTION_MILL, DEM_INTEGRATOR_FORWARD_EULER, mill_dt, 0.003 + 1e-3*i);
            for (k = 0; k < 3; k++) CHECK_NEAR(d.e[k], 0.71, 0.01);
            CHECK(d.aside <= 0);
            CHECK(d.spin <= 0);
        }
    }
    return test_end();
}
