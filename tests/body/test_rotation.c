/* How bodies turn: free bodies against Jacobi's elliptic functions and a Runge-Kutta reference, by
   every rotation integrator; a spheroid that spins on a smooth floor against steady precession.
   Published numbers: [PRI] Principia's euler_solver_test, with exact values worked out by elliptic
   functions; [HUG] MrHuggs/Poinsot; [KRA] Kratos benchmark 30, after Zhao & van Wachem 2013;
   [TBS13] Takahashi, Busch & Scheeres 2013: Toutatis. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const double pi = 3.14159265358979323846;
static const dem_rotation rotations[3] = {DEM_ROTATION_SPIRAL, DEM_ROTATION_FINCHAM,
                                          DEM_ROTATION_NO_SQUISH};
#define SINGLE (sizeof(dem_real) == sizeof(float))

/* A body with these principal moments about x, y, z of its own frame (kg m2), 1 kg, alone. */
static dem_body body_with(dem_world *world, double ix, double iy, double iz) {
    const dem_real origin[3] = {0, 0, 0};
    dem_material_desc stuff = scene_stuff(1e6, 0.5, 0, 0);
    dem_cluster_desc desc = DEM_CLUSTER_DESC;
    dem_quat as_given = dem_quat_make(1, 0, 0, 0);
    stuff.density = 1;
    desc.count = 1;
    desc.positions = origin;
    desc.radius = 1;
    desc.mass = DEM_CLUSTER_GIVEN;
    desc.volume = 1;
    desc.inertia[0] = (dem_real)ix;
    desc.inertia[1] = (dem_real)iy;
    desc.inertia[2] = (dem_real)iz;
    return dem_body_add(world, dem_material_add(world, &stuff), dem_shape_cluster_add(world, &desc),
                        at(0, 0, 0), as_given);
}
static dem_world *free_world(dem_rotation rotation, double dt) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.threads = 1;
    desc.dt = (dem_real)dt;
    desc.allow_large_dt = 1;                 /* nothing touches */
    desc.rotation = rotation;
    return dem_world_create(&desc);
}
typedef struct turned { double w[3], q[4], energy, angular[3], norm; } turned;
static turned look(const dem_world *world, dem_body body) { /* spin in the body's own frame */
    const dem_body_state s = scene_state(world, body);
    const dem_vec3 w = dem_quat_unrotate(s.orientation, s.spin);
    const dem_totals t = dem_totals_get(world);
    turned out;
    out.w[0] = (double)w.x; out.w[1] = (double)w.y; out.w[2] = (double)w.z;
    out.q[0] = (double)s.orientation.w; out.q[1] = (double)s.orientation.x;
    out.q[2] = (double)s.orientation.y; out.q[3] = (double)s.orientation.z;
    out.norm = sqrt(out.q[0]*out.q[0] + out.q[1]*out.q[1] + out.q[2]*out.q[2] + out.q[3]*out.q[3]);
    out.energy = t.rotational;
    memcpy(out.angular, t.angular, sizeof out.angular);
    return out;
}
/* angle (rad) between two orientations, both of length one */
static double angle_between(const double *p, const double *q) {
    double apart = 0, other = 0;
    int i;
    for (i = 0; i < 4; i++) {
        apart += (p[i] - q[i])*(p[i] - q[i]);
        other += (p[i] + q[i])*(p[i] + q[i]);
    }
    return 2*sqrt(apart < other ? apart : other);
}
/* what a free body does after `time` s, spin given in its own frame */
static turned fly(dem_rotation rotation, const double *inertia, const double *w, const double *q,
                  double dt, double time) {
    dem_world *world = free_world(rotation, dt);
    const dem_body body = body_with(world, inertia[0], inertia[1], inertia[2]);
    dem_body_state s = scene_state(world, body);
    turned out;
    if (q) s.orientation = dem_quat_make((dem_real)q[0], (dem_real)q[1], (dem_real)q[2],
                                         (dem_real)q[3]);
    s.spin = dem_quat_rotate(s.orientation, at(w[0], w[1], w[2]));
    CHECK_EQ(dem_body_set(world, body, &s), DEM_OK);
    scene_step(world, (int)(time/dt + 0.5));
    out = look(world, body);
    dem_world_destroy(world);
    return out;
}

/* Euler's equations and q' = q w/2 by the classical Runge-Kutta scheme; y = w, q. */
static void euler_rates(const double *inertia, const double *y, double *r) {
    const double *w = y, *q = y + 3;
    r[0] = (inertia[1] - inertia[2])*w[1]*w[2]/inertia[0];
    r[1] = (inertia[2] - inertia[0])*w[2]*w[0]/inertia[1];
    r[2] = (inertia[0] - inertia[1])*w[0]*w[1]/inertia[2];
    r[3] = (-q[1]*w[0] - q[2]*w[1] - q[3]*w[2])/2;
    r[4] = (q[0]*w[0] + q[2]*w[2] - q[3]*w[1])/2;
    r[5] = (q[0]*w[1] + q[3]*w[0] - q[1]*w[2])/2;
    r[6] = (q[0]*w[2] + q[1]*w[1] - q[2]*w[0])/2;
}
static void euler_solve(const double *inertia, double *y, double dt, int steps) {
    double k[4][7], z[7];
    int n, i, j;
    for (n = 0; n < steps; n++) {
        euler_rates(inertia, y, k[0]);
        for (j = 1; j < 4; j++) {
            for (i = 0; i < 7; i++) z[i] = y[i] + (j < 3 ? dt/2 : dt)*k[j - 1][i];
            euler_rates(inertia, z, k[j]);
        }
        for (i = 0; i < 7; i++) y[i] += dt*(k[0][i] + 2*k[1][i] + 2*k[2][i] + k[3][i])/6;
    }
}

/* Times at which the spin about the middle axis changes sign. */
static int flips(dem_rotation rotation, const double *inertia, const double *w, double dt,
                 double time, double *when, int most) {
    dem_world *world = free_world(rotation, dt);
    const dem_body body = body_with(world, inertia[0], inertia[1], inertia[2]);
    double before = w[1];
    int count = 0, i;
    scene_move(world, body, at(0, 0, 0), at(w[0], w[1], w[2]));
    for (i = 1; i*dt < time && count < most; i++) {
        double now;
        scene_step(world, 1);
        now = look(world, body).w[1];
        if ((now > 0) != (before > 0)) when[count++] = dt*(i - now/(now - before));
        before = now;
    }
    dem_world_destroy(world);
    return count;
}

/* ---- a spheroid on a smooth floor ---- */

/* Semi-axes b, b, a, the axis leaning by `lean` from the vertical and precessing at `rate` (rad/s)
   about it: steady when I1 rate2 cos sin - I3 w3 rate sin = m g dh/dlean, with h the height of the
   centre, sqrt(a2 cos2 + b2 sin2), since the floor pushes with m g along h's gradient. */
typedef struct top { double lean, azimuth, height, drift; } top;
static top spin_on_floor(dem_rotation rotation, double dt, double time, double lean, double rate) {
    const double a = 0.02, b = 0.01, g = 9.81, stiffness = 4e4;
    const double h = sqrt(a*a*cos(lean)*cos(lean) + b*b*sin(lean)*sin(lean));
    const double slope = (b*b - a*a)*sin(lean)*cos(lean)/h;
    const double mass = 2500*4*pi/3*a*b*b, i1 = mass*(a*a + b*b)/5, i3 = mass*2*b*b/5;
    const double w3 = (i1*rate*rate*cos(lean) - mass*g*slope/sin(lean))/(i3*rate);
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = scene_stuff(1e7, 1, 0, 0);
    dem_world *world;
    dem_material material;
    dem_body body;
    dem_body_state s;
    dem_vec3 axis;
    top out;
    double l0;
    stuff.stiffness = (dem_real)stiffness;
    desc.threads = 1;
    desc.dt = (dem_real)dt;
    desc.allow_large_dt = 1;
    desc.gravity.z = DEM_R(-9.81);
    desc.normal_law = DEM_NORMAL_LINEAR;
    desc.rotation = rotation;
    world = dem_world_create(&desc);
    material = dem_material_add(world, &stuff);
    dem_wall_plane_add(world, material, at(0, 0, 0), at(0, 0, 1));
    body = dem_body_add(world, material, dem_shape_ellipsoid_add(world, at(b, b, a)),
                        at(0, 0, h - mass*g/stiffness),
                        dem_quat_about(at(0, 1, 0), (dem_real)lean));
    s = scene_state(world, body);
    axis = dem_quat_rotate(s.orientation, at(0, 0, 1));
    { /* w = rate z + (w3 - rate cos) axis */
        const double along = w3 - rate*cos(lean);
        s.spin = at(along*(double)axis.x, along*(double)axis.y, rate + along*(double)axis.z);
    }
    dem_body_set(world, body, &s);
    l0 = dem_totals_get(world).angular[2];
    scene_step(world, (int)(time/dt + 0.5));
    s = scene_state(world, body);
    axis = dem_quat_rotate(s.orientation, at(0, 0, 1));
    out.lean = acos((double)axis.z);
    out.azimuth = atan2((double)axis.y, (double)axis.x);
    out.height = (double)s.position.z;
    out.drift = dem_totals_get(world).angular[2]/l0 - 1;
    dem_world_destroy(world);
    return out;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("a quaternion and its inverse cancel, and a product rotates by its right factor first") {
        const dem_quat p = dem_quat_about(at(1, 2, 3), DEM_R(0.7));
        const dem_quat q = dem_quat_about(at(-2, 0.5, 1), DEM_R(2.1));
        const dem_vec3 v = at(0.3, -1.2, 0.8), z = dem_quat_rotate(dem_quat_about(at(0, 0, 2),
                                                                 (dem_real)(pi/2)), at(1, 0, 0));
        const dem_vec3 back = dem_quat_unrotate(p, dem_quat_rotate(p, v));
        const dem_vec3 once = dem_quat_rotate(dem_quat_multiply(p, q), v);
        const dem_vec3 twice = dem_quat_rotate(p, dem_quat_rotate(q, v));
        const double eps = SINGLE ? 1e-6 : 1e-15;      /* round-off */
        CHECK_NEAR(back.x, v.x, 2*eps); CHECK_NEAR(back.y, v.y, 2*eps);
        CHECK_NEAR(back.z, v.z, 2*eps);
        CHECK_NEAR(once.x, twice.x, 2*eps); CHECK_NEAR(once.y, twice.y, 2*eps);
        CHECK_NEAR(once.z, twice.z, 2*eps);
        CHECK_NEAR(z.x, 0, eps); CHECK_NEAR(z.y, 1, eps); CHECK_NEAR(z.z, 0, eps);
    }

    TEST("a free body of moments 1, 2, 3 and spin 1, 1, 1 follows the elliptic functions") {
        const double inertia[3] = {1, 2, 3}, w[3] = {1, 1, 1};
        const double w10[3] = {-.60347042, -1.27899314, .88772679};
        const double w100[3] = {-.50976625, -1.31914304, .86792120};
        const double q10[4] = {.46254544, -.31433515, .04942963, .82752755};
        int r, i;
        for (r = 0; r < 3; r++) {
            const turned a = fly(rotations[r], inertia, w, 0, 1e-3, 10);
            const turned b = fly(rotations[r], inertia, w, 0, 1e-3, 100);
            /* second order: (dt w)2 times ten turns is 1e-5 or so */
            for (i = 0; i < 3; i++) CHECK_NEAR(a.w[i], w10[i], SINGLE ? 1e-3 : 1e-4);
            CHECK_NEAR(angle_between(a.q, q10), 0, SINGLE ? 1e-3 : 1e-4);
            for (i = 0; i < 3; i++)                    /* ten times as far */
                CHECK_NEAR(b.w[i], w100[i], SINGLE ? 0.05 : 1e-3);
        }
    }

    TEST("halving the step quarters the error of a free body's orientation, for every integrator") {
        const double inertia[3] = {1, 2, 3}, w[3] = {1, 1, 1};
        double y[7] = {1, 1, 1, 1, 0, 0, 0};
        int r;
        if (SINGLE) { CHECK(1); continue; }            /* errors are near round-off */
        euler_solve(inertia, y, 1e-3, 10000);          /* fourth order: 1e-12 */
        for (r = 0; r < 3; r++) {
            const double e0 = angle_between(fly(rotations[r], inertia, w, 0, 0.04, 10).q, y + 3);
            const double e1 = angle_between(fly(rotations[r], inertia, w, 0, 0.02, 10).q, y + 3);
            const double e2 = angle_between(fly(rotations[r], inertia, w, 0, 0.01, 10).q, y + 3);
            const double slope[2] = {log(e0/e1)/log(2.0), log(e1/e2)/log(2.0)};
            if (rotations[r] == DEM_ROTATION_SPIRAL) { /* without torques third order shows */
                CHECK(slope[0] > 1.9 && slope[0] < 3.2);
                CHECK(slope[1] > 1.9 && slope[1] < 3.2);
            } else { CHECK_NEAR(slope[0], 2, 0.1); CHECK_NEAR(slope[1], 2, 0.1); }
        }
    }

    TEST("a free body keeps its quaternion of length one and its angular momentum") {
        const double inertia[3] = {1, 2, 3}, w[3] = {1, 1, 1};
        int r, i;
        for (r = 0; r < 3; r++) {
            const turned a = fly(rotations[r], inertia, w, 0, 1e-2, 1000);
            const double eps = SINGLE ? 1e-4 : 1e-12;  /* 1e5 steps of round-off, at random */
            CHECK_NEAR(a.norm, 1, SINGLE ? 1e-6 : 1e-14);
            for (i = 0; i < 3; i++) CHECK_NEAR(a.angular[i], inertia[i]*w[i], 4*eps);
        }
    }

    TEST("NO_SQUISH keeps a free body's energy in a fixed band for a million steps") {
        const double inertia[3] = {1, 2, 3}, dt = 0.02;
        dem_world *world = free_world(DEM_ROTATION_NO_SQUISH, dt);
        const dem_body body = body_with(world, inertia[0], inertia[1], inertia[2]);
        double first = 0, last = 0, widest = 0;
        int i;
        scene_move(world, body, at(0, 0, 0), at(1, 1, 1));
        for (i = 0; i < 10000; i++) {
            double e;
            scene_step(world, 100);
            e = dem_totals_get(world).rotational/3 - 1;
            if (fabs(e) > widest) widest = fabs(e);
            if (i < 1000) first += e/1000;
            if (i >= 9000) last += e/1000;
        }
        CHECK_NEAR(widest, 0, 1e-3);                   /* (dt w)2 */
        CHECK_NEAR(last - first, 0, SINGLE ? 1e-3 : 2e-6); /* means of 1000 out of a band of 1e-4 */
        dem_world_destroy(world);
    }

    TEST("Dzhanibekov's wing nut [PRI]: moments 3, 5, 9 flip over every 59.0554 s") {
        /* No matter has these moments, 9 > 3 + 5, and they are refused. But L moves in the body as
           it does when all 1/I grow alike (L x L/I does not see it): .1 makes a body of them. */
        const double L[3] = {0, 2, 0.01}, inertia[3] = {1/(1/3.0 + 0.1), 1/(1/5.0 + 0.1),
                                                        1/(1/9.0 + 0.1)};
        const double w[3] = {0, L[1]/inertia[1], L[2]/inertia[2]};
        int r, i;
        if (SINGLE) { CHECK(1); continue; }            /* when it flips hangs on the last digits */
        for (r = 0; r < 3; r++) {
            double when[4] = {0, 0, 0, 0};
            CHECK_EQ(flips(rotations[r], inertia, w, 0.01, 215, when, 4), 4);
            CHECK_NEAR(when[0], 118.110887046/4, 0.3); /* one per cent, as published */
            for (i = 1; i < 4; i++) CHECK_NEAR(when[i] - when[i - 1], 59.0554435, 0.59);
            CHECK_NEAR(fly(rotations[r], inertia, w, 0, 0.01, 50).w[1]*inertia[1], -.39989666*5,
                       1e-3);                          /* there L2 hardly changes */
            CHECK_NEAR(fly(rotations[r], inertia, w, 0, 0.01, 100).w[1]*inertia[1], .39449710*5,
                       5e-3);
        }
    }

    TEST("Poinsot's body [HUG]: moments 0.3, 0.35, 0.4 at 15 rad/s flip every 6.1675 s") {
        const double inertia[3] = {0.3, 0.35, 0.4}, w[3] = {0.1, 15, 0.1};
        int r, i;
        if (SINGLE) { CHECK(1); continue; }            /* as above */
        for (r = 0; r < 3; r++) {
            double when[4] = {0, 0, 0, 0};
            /* Fincham gains energy, so that flips come later each time: 1.3 % at a step of 1 ms */
            CHECK_EQ(flips(rotations[r], inertia, w, 5e-4, 26, when, 4), 4);
            for (i = 1; i < 4; i++) CHECK_NEAR(when[i] - when[i - 1], 12.334945809/2, 0.062);
        }
    }

    TEST("a symmetric body [KRA] nutates as sin and cos of 50 t in its own frame") {
        const double inertia[3] = {1, 1, 0.5}, w[3] = {0, 1, 100};
        int r;
        for (r = 0; r < 3; r++) {                      /* a step turns it by a tenth of a radian */
            const turned a = fly(rotations[r], inertia, w, 0, 1e-3, 0.01);
            CHECK_NEAR(a.w[0], sin(0.5), 5e-4);
            CHECK_NEAR(a.w[1], cos(0.5), 5e-4);
            CHECK_NEAR(a.w[2], 100, 1e-3);
        }
    }

    TEST("Toutatis [TBS13] tumbles for 20 days as a Runge-Kutta reference does") {
        const double inertia[3] = {3.0836, 3.235, 1}, degree = pi/180;
        const double w[3] = {14.51*degree, 33.529*degree, -98.709*degree};   /* rad a day */
        const double phi = 145.498*degree, theta = 65.865*degree, psi = 241.524*degree;
        const double q[4] = {cos(theta/2)*cos((phi + psi)/2), sin(theta/2)*cos((phi - psi)/2),
                             sin(theta/2)*sin((phi - psi)/2), cos(theta/2)*sin((phi + psi)/2)};
        double y[7], energy = 0;
        int r, i;
        for (i = 0; i < 3; i++) { y[i] = w[i]; energy += inertia[i]*w[i]*w[i]/2; }
        for (i = 0; i < 4; i++) y[3 + i] = q[i];
        euler_solve(inertia, y, 1e-3, 20000);          /* fourth order: 1e-12 */
        for (r = 0; r < 3; r++) {
            const turned a = fly(rotations[r], inertia, w, q, 1e-4, 20), b =
                fly(rotations[r], inertia, w, q, 1e-4, 1e-4);
            CHECK_NEAR(angle_between(a.q, y + 3), 0, SINGLE ? 3e-2 : 1e-6);  /* as published; single: 200,000 round-offs */
            for (i = 0; i < 3; i++)
                CHECK_NEAR(a.angular[i], b.angular[i], SINGLE ? 1e-3 : 1e-11);
            CHECK_REL(a.energy, energy, SINGLE ? 3e-3 : 1e-7);    /* (dt w)2 */
        }
    }

    TEST("a needle, a disc, a three-axis body fly 100,000 steps at 1e5 rad/s without losing L") {
        const double inertia[3][3] = {{1, 1, 1e-3}, {1, 1, 2}, {1, 1.7, 2.4}};
        const double w[3] = {6e4, 5e4, 6.2e4};
        int r, k, i;
        for (r = 0; r < 3; r++)
            for (k = 0; k < 3; k++) {
                /* Fincham's leapfrog gains energy, of a needle until it turns radians a step and is
                   stopped (3e4 steps of 1e-7 s): a smaller step for that */
                const double step = k == 0 && rotations[r] == DEM_ROTATION_FINCHAM ? 2e-8 : 1e-7;
                const turned a = fly(rotations[r], inertia[k], w, 0, step, 1e5*step);
                double l = 0;
                for (i = 0; i < 3; i++) l += pow(inertia[k][i]*w[i], 2);
                CHECK_NEAR(a.norm, 1, SINGLE ? 1e-6 : 1e-14);
                for (i = 0; i < 3; i++)                /* relative to the whole; round-off */
                    CHECK_NEAR(a.angular[i], inertia[k][i]*w[i], sqrt(l)*(SINGLE ? 1e-3 : 1e-10));
            }
    }

    TEST("spheres rotate by exactly spin times time when orientations are followed") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_material_desc stuff = scene_stuff(1e6, 0.5, 0, 0);
        dem_world *world;
        dem_body body;
        dem_body_state s;
        const dem_quat q = dem_quat_about(at(1, 2, -2), DEM_R(3*0.5));
        desc.threads = 1;
        desc.dt = DEM_R(1e-3);
        desc.orientations = 1;
        desc.allow_large_dt = 1;
        world = dem_world_create(&desc);
        body = dem_sphere_add(world, dem_material_add(world, &stuff), DEM_R(0.1), at(0, 0, 0));
        scene_move(world, body, at(0, 0, 0), at(1, 2, -2));      /* 3 rad/s */
        scene_step(world, 500);
        s = scene_state(world, body);
        CHECK_NEAR(s.orientation.w, q.w, SINGLE ? 1e-4 : 1e-12); /* round-off of 500 products */
        CHECK_NEAR(s.orientation.x, q.x, SINGLE ? 1e-4 : 1e-12);
        CHECK_NEAR(s.orientation.y, q.y, SINGLE ? 1e-4 : 1e-12);
        CHECK_NEAR(s.orientation.z, q.z, SINGLE ? 1e-4 : 1e-12);
        dem_world_destroy(world);
    }

    TEST("a sphere's orientation stays a rotation at 0.01 to 100 rad per step") {
        static const double turns[5] = {0.01, 1, 2, 6.6, 100};
        int k;
        for (k = 0; k < 5; k++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_material_desc stuff = scene_stuff(1e6, 0.5, 0, 0);
            dem_world *world;
            dem_body body;
            dem_quat q;
            desc.threads = 1;
            desc.dt = DEM_R(1e-3);
            desc.orientations = 1;
            desc.allow_large_dt = 1;
            world = dem_world_create(&desc);
            body = dem_sphere_add(world, dem_material_add(world, &stuff), DEM_R(0.1), at(0, 0, 0));
            scene_move(world, body, at(0, 0, 0), at(0, 0.6*turns[k]/1e-3, 0.8*turns[k]/1e-3));
            scene_step(world, 1000);
            q = scene_state(world, body).orientation;
            CHECK_NEAR(q.w*q.w + q.x*q.x + q.y*q.y + q.z*q.z, 1, SINGLE ? 1e-6 : 1e-14);
            dem_world_destroy(world);
        }
    }

    TEST("a spheroid spinning on a smooth floor precesses steadily, as a heavy top does") {
        const double lean = 1, rate = 20, time = 0.2;  /* 4 rad of precession */
        int r;
        for (r = 0; r < 3; r++) {
            const top a = spin_on_floor(rotations[r], 2e-5, time, lean, rate);
            double turn = a.azimuth - rate*time;
            turn -= 2*pi*floor(turn/(2*pi) + 0.5);
            /* the floor gives by m g/k, 5e-4 of the height; scheme: (dt w)2 */
            CHECK_NEAR(a.lean, lean, 2e-3);
            CHECK_NEAR(turn, 0, 4e-3);
            CHECK_NEAR(a.drift, 0, SINGLE ? 1e-4 : 1e-9); /* no torque about the vertical */
        }
    }

    TEST("under a torque that varies in time, halving the step quarters the error") {
        /* The heavy top of Simo & Wong needs a pivot, which there is none of: the floor's push on a
           leaning spheroid that is not in steady motion takes its place. It never leaves the floor,
           so that forces stay smooth. */
        int r;
        if (SINGLE) { CHECK(1); continue; }
        for (r = 0; r < 3; r++) {
            const double lean = 1, rate = 20, time = 0.05;
            const top exact = spin_on_floor(rotations[r], 1.25e-6, time, lean, rate);
            double e[3], height[3], dt = 8e-5;
            int i;
            for (i = 0; i < 3; i++, dt /= 2) {
                const top a = spin_on_floor(rotations[r], dt, time, lean, rate);
                e[i] = hypot(a.lean - exact.lean, (a.azimuth - exact.azimuth)*sin(lean));
                height[i] = fabs(a.height - exact.height);
            }
            CHECK_NEAR(log(e[1]/e[2])/log(2.0), 2, 0.2);  /* asked .1 of Simo & Wong's top */
            CHECK(log(height[0]/height[2])/log(4.0) > 1.5);
        }
    }
    return test_end();
}
