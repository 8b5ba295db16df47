/* tumbler.h - how a tumbling screening machine moves: the frames of its barrel and its plates, as a
   function for DEM_MOTION_USER. MIT licence. Include it after dem.h.

   The machine is that of [ALK07] sections 4.2 and 4.3.2. A main shaft rotates with `speed` about the
   vertical. It carries a plate inclined by alpha and beta. On the plate, off the axis of the main
   shaft by `eccentricity`, an auxiliary shaft carries the barrel. Relative to the ground the barrel
   rotates by psi about its own axis, which tumbles. Z, C and B are rotations of the coordinates about
   z, x and y; phi = phase + speed t, chi = psi - phi:

       A_lg = Z(chi) B(beta) C(alpha) Z(phi)           eq 4.2, 4.3; local = A_lg (world - r_oc)
       r_oc = Z(phi)^T p,  p = (u (1 - cos b), eps - e (1 - cos a) - u sin a sin b,
                                u sin b cos a + e sin a)                                  eq 4.1
       spin = phi' z + chi' A_lg^T z,   velocity = phi' z x r_oc

   [ALK07] prints derivatives of all nine elements of A_lg instead. We correct three misprints:
     4.13  A11', A12', A22': "(w_b - w) cos(w_b - w)t cos(wt)" must have the sine of (w_b - w)t
     4.15  has ten lines for nine elements: the fifth, named A22', is A22 itself, and the names of
           those after it lag by one (the line named A23' is A22', and so on: A33' appears twice)
     4.7   the swing back must end where it began: w_b (2 n dt - (t - t_s)). The thesis prints
           -w_b (t - t_s) - 2 n dt, which mixes an angle with a time
   Tests: tests/examples/test_tumbler.c. */
#ifndef TUMBLER_H
#define TUMBLER_H
#include <math.h>

typedef struct tumbler {
    double speed;                  /* rad/s, of the main shaft */
    double alpha, beta;            /* rad, inclination of the plate */
    double u, e;                   /* m, dimensions of the plate */
    double eccentricity;           /* m */
    double phase;                  /* rad, of the main shaft at the start */
    double factor;                 /* K: speed of the barrel about its own axis over `speed`. 1: it
                                      rotates freely, 0: it is held */
    double period;                 /* s; > 0: the barrel swings to and fro at constant speed; 0: it
                                      rotates in one direction */
} tumbler;

/* Returns the angle psi of the barrel (rad) and writes its rate (rad/s), eq 4.6 and 4.7. At a turning
   point the rate is that of the half period that begins. */
static inline double tumbler_swing(const tumbler *m, double time, double *rate) {
    const double speed = m->factor*m->speed;
    double t;
    *rate = speed;
    if (!(m->period > 0)) return speed*time;
    t = time - floor(time/m->period)*m->period;
    if (t < m->period/2) return speed*t;
    *rate = -speed;
    return speed*(m->period - t);
}

/* Writes rotation (row-major, local to world), position, velocity and spin of the barrel. */
static inline void tumbler_barrel(const tumbler *m, double time, double R[9], double x[3],
                                  double v[3], double spin[3]) {
    const double phi = fmod(m->phase + m->speed*time, 6.283185307179586476925);
    const double ca = cos(m->alpha), sa = sin(m->alpha), cb = cos(m->beta), sb = sin(m->beta);
    const double c = cos(phi), s = sin(phi);
    const double p[3] = {m->u*(1 - cb), m->eccentricity - m->e*(1 - ca) - m->u*sa*sb,
                         m->u*sb*ca + m->e*sa};
    const double bc[9] = {cb, sa*sb, -ca*sb, 0, ca, sa, sb, -sa*cb, ca*cb};   /* B C */
    double rate, chi, cx, sx, a[9];
    int i;
    chi = tumbler_swing(m, time, &rate);
    chi = fmod(chi, 6.283185307179586476925) - phi;
    cx = cos(chi);
    sx = sin(chi);
    for (i = 0; i < 3; i++) {                   /* A = Z(chi) (B C) Z(phi) */
        a[i] = cx*bc[i] + sx*bc[3 + i];
        a[3 + i] = -sx*bc[i] + cx*bc[3 + i];
        a[6 + i] = bc[6 + i];
    }
    for (i = 0; i < 3; i++) {
        const double first = a[3*i], second = a[3*i + 1];
        a[3*i] = first*c - second*s;
        a[3*i + 1] = first*s + second*c;
    }
    for (i = 0; i < 9; i++) R[i] = a[3*(i%3) + i/3];
    x[0] = c*p[0] - s*p[1];
    x[1] = s*p[0] + c*p[1];
    x[2] = p[2];
    v[0] = -m->speed*x[1];
    v[1] = m->speed*x[0];
    v[2] = 0;
    for (i = 0; i < 3; i++) spin[i] = (rate - m->speed)*R[3*i + 2] + (i == 2 ? m->speed : 0);
}

/* A wall of the machine and its position in the frame of the barrel; motion.user points to it. */
typedef struct tumbler_part { const tumbler *machine; double place[3]; } tumbler_part;
static inline void tumbler_frame(double time, dem_pose *pose, void *user) {
    const tumbler_part *part = (const tumbler_part *)user;
    double R[9], x[3], v[3], w[3], at[3];
    int i;
    tumbler_barrel(part->machine, time, R, x, v, w);
    for (i = 0; i < 3; i++)
        at[i] = R[3*i]*part->place[0] + R[3*i + 1]*part->place[1] + R[3*i + 2]*part->place[2];
    for (i = 0; i < 9; i++) pose->rotation[i] = (dem_real)R[i];
    pose->position = dem_vec3_make((dem_real)(x[0] + at[0]), (dem_real)(x[1] + at[1]),
                                   (dem_real)(x[2] + at[2]));
    pose->velocity = dem_vec3_make((dem_real)(v[0] + w[1]*at[2] - w[2]*at[1]),
                                   (dem_real)(v[1] + w[2]*at[0] - w[0]*at[2]),
                                   (dem_real)(v[2] + w[0]*at[1] - w[1]*at[0]));
    pose->spin = dem_vec3_make((dem_real)w[0], (dem_real)w[1], (dem_real)w[2]);
}
static inline dem_motion tumbler_motion(tumbler_part *part) {
    dem_motion motion = DEM_MOTION;
    motion.kind = DEM_MOTION_USER;
    motion.function = tumbler_frame;
    motion.user = part;
    return motion;
}
#endif
