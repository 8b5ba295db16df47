/* The frame of a tumbling screening machine (examples/tumbler.h): against the printed matrices,
   against finite differences, and under a grain that sticks to it. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../../examples/tumbler.h"
#include "../test.h"
#include "../scene.h"

static tumbler machine(double factor, double period) {
    tumbler m;
    m.speed = 5.2;
    m.alpha = 0.3; m.beta = 0.2;               /* far steeper than any machine: errors show */
    m.u = 0.4; m.e = 0.3; m.eccentricity = 0.05;
    m.factor = factor; m.period = period;
    m.phase = 0;
    return m;
}
/* Eq 4.3 as printed; b: angle of the barrel. */
static void printed_matrix(const tumbler *m, double t, double b, double A[9]) {
    const double p = m->speed*t, x = b - p;
    const double C = cos(p), S = sin(p), c = cos(x), s = sin(x);
    const double ca = cos(m->alpha), sa = sin(m->alpha), cb = cos(m->beta), sb = sin(m->beta);
    A[0] = c*C*cb - c*S*sa*sb - s*S*ca;
    A[1] = c*S*cb + c*C*sa*sb + s*C*ca;
    A[2] = -c*ca*sb + s*sa;
    A[3] = -s*C*cb + s*S*sa*sb - c*S*ca;
    A[4] = -s*S*cb - s*C*sa*sb + c*C*ca;
    A[5] = s*ca*sb + c*sa;
    A[6] = C*sb + S*sa*cb;
    A[7] = S*sb - C*sa*cb;
    A[8] = ca*cb;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("rotation and position of the barrel are eq 4.1 and 4.3 of the thesis, for a free, held, driven or swinging "
         "barrel") {
        static const double factor[4] = {1, 0, 0.4, 0.7}, period[4] = {0, 0, 0, 0.31};
        int i, k, n;
        for (i = 0; i < 4; i++)
            for (n = 0; n < 20; n++) {
                const tumbler m = machine(factor[i], period[i]);
                const double t = 0.173*n, p = m.speed*t, C = cos(p), S = sin(p);
                const double ca = cos(m.alpha), sa = sin(m.alpha), cb = cos(m.beta);
                const double sb = sin(m.beta), eps = m.eccentricity;
                double R[9], x[3], v[3], w[3], A[9], rate;
                tumbler_barrel(&m, t, R, x, v, w);
                printed_matrix(&m, t, tumbler_swing(&m, t, &rate), A);
                for (k = 0; k < 9; k++) CHECK_NEAR(R[k], A[3*(k%3) + k/3], 1e-13);
                CHECK_NEAR(x[0], m.u*C - m.u*C*cb + m.e*S - eps*S + m.u*S*sa*sb - m.e*S*ca, 1e-14);
                CHECK_NEAR(x[1], m.u*S - m.u*S*cb - m.e*C + eps*C - m.u*C*sa*sb + m.e*C*ca, 1e-14);
                CHECK_NEAR(x[2], m.u*sb*ca + m.e*sa, 1e-14);
            }
    }

    TEST("a phase of the main shaft is a later start of a held barrel") {
        tumbler early = machine(0, 0);
        const tumbler late = early;
        double R[2][9], x[2][3], v[2][3], w[2][3];
        int k;
        early.phase = 0.7;
        tumbler_barrel(&early, 0.2, R[0], x[0], v[0], w[0]);
        tumbler_barrel(&late, 0.2 + 0.7/late.speed, R[1], x[1], v[1], w[1]);
        for (k = 0; k < 9; k++) CHECK_NEAR(R[0][k], R[1][k], 1e-14);
        for (k = 0; k < 3; k++) {
            CHECK_NEAR(x[0][k], x[1][k], 1e-15);
            CHECK_NEAR(v[0][k], v[1][k], 1e-14);
            CHECK_NEAR(w[0][k], w[1][k], 1e-14);
        }
    }

    TEST("the frame's velocity and spin are the derivatives of its place and rotation") {
        static const double factor[4] = {1, 0, 0.4, 0.7}, period[4] = {0, 0, 0, 0.31};
        int i, k, n;
        for (i = 0; i < 4; i++)
            for (n = 0; n < 40; n++) {
                const tumbler m = machine(factor[i], period[i]);
                tumbler_part part;
                const double t = 0.0371 + 0.173*n, h = 1e-4;
                dem_pose now, to[4];
                double a[4][12], rate[12], w[3];
                part.machine = &m;
                part.place[0] = 0.2; part.place[1] = -0.1; part.place[2] = 0.6;
                tumbler_frame(t, &now, &part);
                for (k = 0; k < 4; k++) {      /* fourth order: -2h, -h, h, 2h */
                    int e;
                    tumbler_frame(t + h*(k < 2 ? k - 2 : k - 1), &to[k], &part);
                    for (e = 0; e < 9; e++) a[k][e] = (double)to[k].rotation[e];
                    a[k][9] = (double)to[k].position.x;
                    a[k][10] = (double)to[k].position.y;
                    a[k][11] = (double)to[k].position.z;
                }
                for (k = 0; k < 12; k++)
                    rate[k] = (a[0][k] - 8*a[1][k] + 8*a[2][k] - a[3][k])/(12*h);
                CHECK_NEAR((double)now.velocity.x, rate[9], 1e-6);
                CHECK_NEAR((double)now.velocity.y, rate[10], 1e-6);
                CHECK_NEAR((double)now.velocity.z, rate[11], 1e-6);
                for (k = 0; k < 3; k++) {      /* R' R^T is the spin's cross product */
                    const int p = (k + 2)%3, q = (k + 1)%3;
                    int e;
                    for (w[k] = 0, e = 0; e < 3; e++)
                        w[k] += rate[3*p + e]*(double)now.rotation[3*q + e];
                }
                CHECK_NEAR((double)now.spin.x, w[0], 1e-6);
                CHECK_NEAR((double)now.spin.y, w[1], 1e-6);
                CHECK_NEAR((double)now.spin.z, w[2], 1e-6);
            }
    }

    TEST("the triangle of a swinging barrel goes to K w t_p/2 and back, without a jump") {
        const tumbler m = machine(0.7, 0.02);
        double rate, before = 0, most = 0;
        int i;
        for (i = 0; i <= 4000; i++) {
            const double psi = tumbler_swing(&m, 1e-5*i, &rate);
            CHECK_NEAR(psi, before, 0.7*m.speed*1e-5*(1 + 1e-6));
            most = fmax(most, before = psi);
        }
        CHECK_NEAR(most, 0.7*m.speed*0.02/2, 1e-9);                    /* eq 4.6 */
        CHECK_NEAR(tumbler_swing(&m, 0.04, &rate), 0, 1e-9);
    }

    TEST("three elements of eq 4.13 and the labels of 4.15 are misprints, the rest are derivatives") {
        /* what the comment of tumbler.h says, held against finite differences */
        const tumbler m = machine(0.4, 0);
        const double t = 0.37, h = 1e-5, w = m.speed, d = 0.4*w - w, x = d*t, p = w*t;
        const double C = cos(p), S = sin(p), c = cos(x), s = sin(x), cb = cos(m.beta);
        const double ca = cos(m.alpha), sa = sin(m.alpha), sb = sin(m.beta);
        double lo[9], hi[9];
        const double printed = (-w*c*S - d*c*C)*cb - (w*c*C - d*s*S)*sa*sb - (w*s*C + d*c*S)*ca;
        const double right = (-w*c*S - d*s*C)*cb - (w*c*C - d*s*S)*sa*sb - (w*s*C + d*c*S)*ca;
        printed_matrix(&m, t - h, 0.4*w*(t - h), lo);
        printed_matrix(&m, t + h, 0.4*w*(t + h), hi);
        CHECK_NEAR(right, (hi[0] - lo[0])/(2*h), 1e-6);
        CHECK(fabs(printed - (hi[0] - lo[0])/(2*h)) > 0.1);
        CHECK_NEAR(d*s*ca*sb + d*c*sa, (hi[2] - lo[2])/(2*h), 1e-6);
    }

    TEST("a grain glued to a tumbling deck keeps its place for 100 turns") {
        static const double factor[2] = {1, 0};
        int i;
        for (i = 0; i < 2; i++) {
            tumbler m = machine(factor[i], 0);
            tumbler_part part;
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_material_desc stuff = DEM_MATERIAL_DESC;
            dem_material glue;
            dem_motion motion;
            dem_world *world;
            dem_wall deck;
            dem_body grain;
            dem_pose pose;
            dem_pair pair;
            dem_vec3 first, last, x;
            m.alpha = 0.0175; m.beta = 0.0113;
            part.machine = &m;
            part.place[0] = part.place[1] = 0;
            part.place[2] = 0.3;
            desc.normal_law = DEM_NORMAL_HYSTERETIC;
            desc.gravity = at(0, 0, -9.81);
            desc.threads = 1;
            desc.dt = DEM_R(2e-4);
            world = dem_world_create(&desc);
            stuff.density = 2500;
            stuff.stiffness = 1000;
            stuff.stiffness_unloading = 1500;
            stuff.stiffness_adhesion = 400;
            stuff.friction = 5;
            stuff.rolling_friction = 5;
            glue = dem_material_add(world, &stuff);
            dem_pair_get(world, glue, glue, &pair);
            pair.normal_damping = 2;
            dem_pair_set(world, glue, glue, &pair);
            deck = scene_floor(world, glue, -0.5, -0.5, 0.5, 0.5, 1, 1);
            motion = tumbler_motion(&part);
            CHECK_EQ(dem_wall_motion_set(world, deck, &motion), DEM_OK);
            dem_wall_pose_get(world, deck, &pose);
            x = demi_add(pose.position, demi_rotate(pose.rotation, at(0.2, 0.1, 0.0095)));
            grain = dem_sphere_add(world, glue, DEM_R(0.01), x);
            scene_move(world, grain, demi_add(pose.velocity, demi_cross(pose.spin,
                       demi_sub(x, pose.position))), pose.spin);
            CHECK_EQ(dem_world_run(world, 2*2*3.14159265/m.speed, 0, 0), DEM_OK);
            dem_wall_pose_get(world, deck, &pose);
            first = demi_unrotate(pose.rotation, demi_sub(scene_state(world, grain).position,
                                                        pose.position));
            CHECK_EQ(dem_world_run(world, 100*2*3.14159265/m.speed, 0, 0), DEM_OK);
            dem_wall_pose_get(world, deck, &pose);
            last = demi_unrotate(pose.rotation, demi_sub(scene_state(world, grain).position,
                                                       pose.position));
            CHECK_NEAR(first.x, 0.2, 1e-3);
            CHECK_NEAR(first.y, 0.1, 1e-3);
            CHECK_NEAR(last.x, (double)first.x, 3e-5);   /* second order: 1e-5 at this dt, of 140 m */
            CHECK_NEAR(last.y, (double)first.y, 3e-5);
            CHECK_NEAR(last.z, (double)first.z, 3e-5);
            dem_world_destroy(world);
        }
    }

    return test_end();
}
