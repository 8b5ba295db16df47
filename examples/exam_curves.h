/* exam_curves.h - the curves of a contact law: force against overlap, slip and angle, and what impacts leave. MIT licence.
   Include it after exam.h. exam.c draws them on a page, web/lab.c in a browser. */
#ifndef EXAM_CURVES_H
#define EXAM_CURVES_H

enum { EXAM_POINTS = 2400 };
typedef struct exam_curve { int count; double x[EXAM_POINTS], y[EXAM_POINTS]; } exam_curve;
static inline void exam_curve_add(exam_curve *c, double x, double y) {
    if (c->count < EXAM_POINTS) { c->x[c->count] = x; c->y[c->count++] = y; }
}
/* Loads, partly unloads, reloads and unloads a contact, from the range and back: force (N) against overlap (m). */
static inline void exam_press(const exam *e, double speed, exam_curve *c) {
    const double deep = e->deep*e->radius, apart = exam_last(e)/deep, turn[5] = {0.7, 0.3, 1, 0.5, apart};
    exam_path p;
    int part, k;
    exam_begin(&p, e);
    c->count = 0;
    for (part = 0; part < 5; part++) {
        const double from = part ? turn[part - 1] : exam_first(e)/deep;
        for (k = 1; k <= 200; k++) {
            exam_go_on(&p, deep*(from + (turn[part] - from)*k/200), 0, 0, 0, 0, 1, speed);
            exam_curve_add(c, (double)p.c.overlap, (double)p.f.normal);
        }
    }
}
/* Slides to and fro by `far` (m), or rolls by it (rad), three times at a constant overlap. */
static inline void exam_cycle(const exam *e, double far, int rolling, exam_curve *c) {
    exam_path p;
    double at = 0;
    int part, k;
    exam_begin(&p, e);
    exam_go_on(&p, e->deep*e->radius, 0, 0, 0, 0, 100, 1e-3*e->speed);
    c->count = 0;
    for (part = 0; part < 6; part++) {
        const double to = part%2 ? -far : far, step = (to - at)/200;
        for (k = 0; k < 200; k++) {
            exam_go_on(&p, e->deep*e->radius, rolling ? 0 : step, 0, rolling ? step : 0, 0, 1, 1e-3*e->speed);
            at += step;
            exam_curve_add(c, at, rolling ? (double)p.f.moment.x : (double)p.f.tangent.x);
        }
        at = to;
    }
}
static inline void exam_bounces(const exam *e, exam_curve *c) {
    int k;
    c->count = 0;
    for (k = 0; k <= 16; k++) {
        exam_impact m;
        memset(&m, 0, sizeof m);
        m.speed = e->speed*pow(10, -2 + k/4.0); m.step = 0.25; m.early = 2.5;
        exam_collide(e, &m);
        if (m.energy >= 0) exam_curve_add(c, m.speed, m.normal/m.speed);
    }
}
/* Energy after over before, and slip over normal speed, against the angle. */
static inline void exam_slants(const exam *e, exam_curve *energy, exam_curve *slip) {
    int k;
    energy->count = slip->count = 0;
    for (k = 0; k <= 34; k++) {
        exam_impact m;
        memset(&m, 0, sizeof m);
        m.speed = e->speed; m.angle = 2.5*k/57.29578; m.step = 0.25; m.early = 2.5;
        exam_collide(e, &m);
        if (m.energy < 0) continue;
        exam_curve_add(energy, 2.5*k, m.energy);
        exam_curve_add(slip, 2.5*k, -m.slip/(m.speed*cos(m.angle)));
    }
}
#endif
