/* naive.c - see naive.h. The order is that of docs/theory.md, and the symbols are those of its tables. */
#include "naive.h"
#include <math.h>
#include <stdlib.h>

typedef struct naive_body {
    int material, fixed;
    double R, m, I;
    naive_vec x, v, w;                 /* at the time of the positions; during a step as predicted */
    naive_vec v_half, w_half;          /* of the step just taken: its displacement over dt */
    naive_vec force, torque;           /* without gravity */
} naive_body;
typedef struct naive_plane { int material; naive_vec point, normal; } naive_plane;
typedef struct naive_memory {          /* of a pair of bodies, or of a body and a plane */
    int touches, slides;               /* slides: bears up to mu, not mu_s, times the load */
    double D, kt;                      /* depth of the hysteretic law; kt of the last step */
    naive_vec xi;                      /* [CS79]: stretched by; other laws: force T_s of the spring */
    naive_vec roll;                    /* moment of the rolling spring */
} naive_memory;
struct naive {
    naive_laws laws;
    naive_material material[NAIVE_MATERIALS];
    naive_pair pair[NAIVE_MATERIALS][NAIVE_MATERIALS];
    naive_body body[NAIVE_BODIES]; naive_plane plane[NAIVE_PLANES];
    naive_memory memory[NAIVE_BODIES][NAIVE_BODIES + NAIVE_PLANES];
    int materials, bodies, planes, started;
    naive_count count;
};
static const double naive_pi = 3.14159265358979323846;

/* ---- vectors ---- */
static naive_vec vec(double x, double y, double z) { naive_vec v; v.x = x; v.y = y; v.z = z; return v; }
static naive_vec plus(naive_vec a, double s, naive_vec b) { return vec(a.x + s*b.x, a.y + s*b.y, a.z + s*b.z); }
static naive_vec minus(naive_vec a, naive_vec b) { return plus(a, -1, b); }
static naive_vec times(double s, naive_vec a) { return vec(s*a.x, s*a.y, s*a.z); }
static double dot(naive_vec a, naive_vec b) { return a.x*b.x + a.y*b.y + a.z*b.z; }
static double size(naive_vec a) { return sqrt(dot(a, a)); }
static naive_vec cross(naive_vec a, naive_vec b) {
    return vec(a.y*b.z - a.z*b.y, a.z*b.x - a.x*b.z, a.x*b.y - a.y*b.x);
}
static naive_vec across(naive_vec a, naive_vec n) { return plus(a, -dot(a, n), n); }

/* ---- materials and pairs: means as the comment at dem_pair defines them ---- */
static naive_pair mixed(const naive_material *a, const naive_material *b) {
    naive_pair p;
    const double nu = (a->poisson + b->poisson)/2;
    p.restitution = sqrt(a->restitution*b->restitution);
    p.friction = sqrt(a->friction*b->friction);
    p.friction_static = sqrt(fmax(a->friction_static, a->friction)*fmax(b->friction_static, b->friction));
    p.rolling_friction = sqrt(a->rolling_friction*b->rolling_friction);
    p.stiffness = 2*a->stiffness*b->stiffness/fmax(a->stiffness + b->stiffness, 1e-30); /* 0 unless both give one */
    p.ratio = a->ratio > 0 && b->ratio > 0 ? sqrt(a->ratio*b->ratio) : 2*(1 - nu)/(2 - nu);
    p.adhesion = sqrt(a->adhesion*b->adhesion);
    p.normal_damping = 0; p.tangent_damping = 1;
    return p;
}
/* 1/E* = sum (1 - nu^2)/E */
static double young_eff(const naive_material *a, const naive_material *b) {
    return 1/((1 - a->poisson*a->poisson)/a->young + (1 - b->poisson*b->poisson)/b->young);
}
/* 1/G* = sum (2 - nu)/G, G = E/(2 (1 + nu)) */
static double shear_eff(const naive_material *a, const naive_material *b) {
    const double Ga = a->young/(2*(1 + a->poisson)), Gb = b->young/(2*(1 + b->poisson));
    return 1/((2 - a->poisson)/Ga + (2 - b->poisson)/Gb);
}
/* The restitution of a dashpot of damping ratio b that does not attract: [SP07], above 1 continued analytically. */
static double restitution_of(double b) {
    if (b < 1) return exp(-b/sqrt(1 - b*b)*acos(2*b*b - 1));
    if (b > 1) return exp(-b/sqrt(b*b - 1)*acosh(2*b*b - 1));
    return exp(-2.0);
}
/* beta = -ln e/sqrt(pi^2 + ln^2 e); COMPENSATED: the b of the closed form, by bisection */
static double damping_ratio(double e, int tension) {
    double low = 0, high = 100;
    int i;
    if (tension != NAIVE_COMPENSATED) return -log(e)/sqrt(naive_pi*naive_pi + log(e)*log(e));
    for (i = 0; i < 200; i++) {
        const double b = (low + high)/2;
        if (restitution_of(b) > e) low = b; else high = b;
    }
    return (low + high)/2;
}

/* ---- one contact ---- */
typedef struct naive_touch {
    const naive_pair *pair;
    const naive_material *a, *b;
    naive_vec n;
    double d, R, m, v_n;               /* overlap, R*, m*, closing speed */
    naive_vec v_t, w;                  /* slip, relative spin across n: of the predicted velocities */
    naive_vec v_t_step, w_step;        /* and of the displacements of the step */
    double share, middle;              /* part of the step in which the two touched, mean overlap of that part */
    double F, elastic, load, ct;       /* results of the normal law */
    double kt, kt_middle, k, k_middle; /* k: dF/dd; middle: at that mean overlap */
    naive_vec T, M;                    /* force and moment on a */
} naive_touch;

static void normal_law(const naive_laws *laws, double dt, naive_touch *c, naive_memory *h) {
    const naive_pair *p = c->pair;
    const double beta = damping_ratio(p->restitution, laws->tension), d = c->d, R = c->R, m = c->m;
    const double E = young_eff(c->a, c->b), G = shear_eff(c->a, c->b);
    const double v = laws->impact_speed > 0 ? laws->impact_speed : 1;
    double kn = p->stiffness > 0 ? p->stiffness : pow(320.0/81*m*v*v*pow(E, 4)*R*R, 0.2), cn = 2*beta*sqrt(kn*m);
    double hold = 0;
    if (p->normal_damping > 0) cn = p->normal_damping;
    c->kt = c->kt_middle = p->ratio*kn;
    c->ct = 2*beta*sqrt(c->kt*m);
    c->k = c->k_middle = kn;
    c->elastic = kn*d;
    if (laws->normal == NAIVE_LINEAR) c->F = c->elastic + cn*c->v_n;
    else if (laws->normal == NAIVE_HERTZ) {
        kn = 4.0/3*E*sqrt(R);
        cn = 2*sqrt(5.0/6)*beta*sqrt(2*E*sqrt(R)*m);
        c->elastic = kn*pow(d, 1.5);
        c->F = c->elastic + cn*pow(d, 0.25)*c->v_n;
        c->kt = 8*G*sqrt(R*d);
        c->kt_middle = 8*G*sqrt(R*c->middle);
        c->ct = 2*sqrt(5.0/6)*beta*sqrt(8*G*sqrt(R)*m)*pow(d, 0.25);
        c->k = 1.5*kn*sqrt(d);
        c->k_middle = 1.5*kn*sqrt(c->middle);
    } else {
        const double kun = kn/(p->restitution*p->restitution), kad = p->adhesion;
        const double D = fmin(fmax(h->D, d), d*(kun + kad)/(kun - kn));
        c->elastic = kun*d - (kun - kn)*D;
        c->F = c->elastic + (p->normal_damping > 0 ? cn : 0)*c->v_n;
        hold = kad*d;
        if (dt > 0) h->D = D;
    }
    c->ct *= p->tangent_damping;
    c->load = laws->load == NAIVE_ELASTIC ? c->elastic : laws->load == NAIVE_MAGNITUDE ? fabs(c->F) : c->F;
    if (laws->tension != NAIVE_ALLOWED) c->load = c->F = fmax(c->F, 0);
    c->load = fmax(c->load + hold, 0);
}
/* Rotates a tangent vector with the normal, which moved by s = n' dt, then about it by the mean twist t of the step. */
static naive_vec rotated(naive_vec v, naive_vec n, naive_vec s, double t) {
    const double along = dot(v, n), cosine = sqrt(1 - dot(s, s));
    v = plus(plus(v, -along, n), along/(1 + cosine), s);
    return plus(times(1 - t*t/2, v), t*(1 - 9*t*t/64), cross(n, v));
}
static void tangent_law(const naive_laws *laws, double dt, naive_touch *c, naive_memory *h, naive_count *count) {
    const double slide = c->pair->friction*c->load, hold = fmax(c->pair->friction_static, c->pair->friction)*c->load;
    naive_vec spring, t, gives;        /* T_s, trial force, force that the spring gives up */
    double cut = 1;
    int slides;
    if (laws->tangent == NAIVE_SPRING) {
        h->xi = plus(h->xi, dt*c->share, c->v_t_step);
        spring = times(-c->kt, h->xi);
    } else {
        /* while unloading T_s/kt is conserved: the increment, too, has the present kt */
        const int unloads = laws->tangent == NAIVE_RESCALED && h->kt > c->kt;
        if (unloads) h->xi = times(c->kt/h->kt, h->xi);
        spring = plus(h->xi, -(unloads ? c->kt : c->kt_middle)*dt*c->share, c->v_t_step);
        if (dt > 0) h->xi = spring;
    }
    t = plus(spring, -c->ct, c->v_t);
    slides = size(t) > (h->slides ? slide : hold) || (h->slides && dot(spring, c->v_t) < 0);
    if (slides && size(t) > slide) cut = slide/size(t);
    c->T = times(cut, t);
    if (dt > 0) h->slides = slides;
    if (dt > 0 && cut < 1) {
        gives = times(1 - cut, t);
        if (laws->slider == NAIVE_PARALLEL) gives = times(c->kt*dt/(c->kt*dt + c->ct), gives);
        if (laws->slider == NAIVE_SLIDER_SPRING) gives = plus(gives, c->ct, c->v_t);
        if (laws->tangent == NAIVE_SPRING) h->xi = plus(h->xi, 1/c->kt, gives);
        else h->xi = minus(h->xi, gives);
    }
    h->kt = c->kt;
    count->slid += cut < 1; count->stuck += cut >= 1;
}
static void rolling_law(const naive_laws *laws, double dt, naive_touch *c, naive_memory *h, naive_count *count) {
    const double mu = c->pair->rolling_friction, limit = mu*c->R*c->load;
    naive_vec t;
    if (laws->rolling == NAIVE_CONSTANT) {
        /* at rest (0.3/dt)^2 I with I = 2/5 m* R*^2, critically damped: 2 sqrt(kr I). Before the first step: none */
        const double I = 2.0/5*c->m*c->R*c->R, kr = dt > 0 ? 0.3/dt*(0.3/dt)*I : 0, cr = 2*sqrt(kr*I);
        double cut = 1;
        h->roll = plus(h->roll, -kr*dt*c->share, c->w_step);
        t = plus(h->roll, -cr, c->w);
        if (size(t) > limit) cut = limit/size(t);
        c->M = times(cut, t);
        if (dt > 0) h->roll = plus(h->roll, -(1 - cut)*kr*dt/(kr*dt + cr), t);
        count->rolled += cut < 1;
    } else {
        /* kr = 2.25 k (mu_r R*)^2, dashpot 0.6 sqrt(kr I) with I = 7/5 m* R*^2 below the limit */
        const double arm = mu*c->R, I = 7.0/5*c->m*c->R*c->R;
        const double kr = 2.25*c->k*arm*arm, kr_middle = 2.25*c->k_middle*arm*arm;
        t = plus(h->roll, -kr_middle*dt*c->share, c->w_step);
        count->rolled += size(t) > limit;
        if (size(t) > limit) c->M = t = times(limit/size(t), t);
        else c->M = plus(t, -0.6*sqrt(kr*I), c->w);
        if (dt > 0) h->roll = t;
    }
}

/* ---- contact geometry ---- */
/* From a to the nearest image of b. */
static naive_vec between(const naive *n, naive_vec a, naive_vec b, int *far_image) {
    const double *p = n->laws.period;
    naive_vec r = minus(b, a);
    if (p[0] > 0) r.x -= p[0]*floor(r.x/p[0] + 0.5);
    if (p[1] > 0) r.y -= p[1]*floor(r.y/p[1] + 0.5);
    if (p[2] > 0) r.z -= p[2]*floor(r.z/p[2] + 0.5);
    *far_image = size(minus(r, minus(b, a))) > 0;
    return r;
}
/* Body i against body j or, if j >= NAIVE_BODIES, plane j - NAIVE_BODIES. dt 0: forces alone, no change of history */
static void touch(naive *n, int i, int j, double dt) {
    const naive_vec zero = vec(0, 0, 0);
    naive_body *a = &n->body[i], rest = n->body[i], *b = j < NAIVE_BODIES ? &n->body[j] : &rest;
    naive_memory *h = &n->memory[i][j];
    naive_touch c;
    double la, lb, twist;
    int far_image = 0, began = !h->touches;
    naive_vec D, turn = zero, middle;
    c.T = c.M = zero;
    if (j < NAIVE_BODIES) {
        const naive_vec r = between(n, a->x, b->x, &far_image);
        const double L = size(r);
        c.n = times(1/L, r);
        c.d = a->R + b->R - L;
        la = a->R*L/(a->R + b->R);
        lb = L - la;
        c.R = 1/(1/a->R + 1/b->R);
        c.m = 1/((a->fixed ? 0 : 1/a->m) + (b->fixed ? 0 : 1/b->m));     /* fixed: infinite mass, as a wall */
    } else {
        const naive_plane *plane = &n->plane[j - NAIVE_BODIES];
        c.n = times(-1, plane->normal);
        c.d = a->R - dot(minus(a->x, plane->point), plane->normal);
        la = c.R = a->R;
        lb = 0;
        c.m = a->m;
        rest.material = plane->material;
        rest.v = rest.w = rest.v_half = rest.w_half = zero;
    }
    h->touches = c.d > 0;
    if (c.d <= 0) return;
    c.pair = &n->pair[a->material][b->material];
    c.a = &n->material[a->material]; c.b = &n->material[b->material];
    /* dashpots: the predicted velocities */
    c.v_n = dot(minus(a->v, b->v), c.n);
    c.v_t = plus(across(minus(a->v, b->v), c.n), 1, cross(plus(times(la, a->w), lb, b->w), c.n));
    c.w = across(minus(a->w, b->w), c.n);
    /* springs: the displacement of the step */
    D = minus(a->v_half, b->v_half);
    if (j < NAIVE_BODIES) turn = times(-1/(la + lb), across(D, c.n));    /* n' */
    middle = plus(c.n, -dt/2, turn);
    c.v_t_step = plus(across(D, middle), 1, cross(plus(times(la, a->w_half), lb, b->w_half), middle));
    c.v_t_step = across(c.v_t_step, c.n);
    c.w_step = across(minus(a->w_half, b->w_half), c.n);
    c.share = c.v_n*dt > c.d ? c.d/(c.v_n*dt) : 1;
    c.middle = c.v_n*dt > c.d ? c.d/2 : c.d - c.v_n*dt/2;
    if (began) {
        h->xi = h->roll = zero;
        h->kt = h->D = h->slides = 0;
    } else if (dt > 0) {
        twist = dot(plus(a->w_half, 1, b->w_half), c.n)/2;               /* mean spin about the normal */
        h->xi = rotated(h->xi, c.n, times(dt, turn), twist*dt);
        h->roll = rotated(h->roll, c.n, times(dt, turn), twist*dt);
    }
    normal_law(&n->laws, dt, &c, h);
    if (n->laws.tangent != NAIVE_SMOOTH) tangent_law(&n->laws, dt, &c, h, &n->count);
    if (n->laws.rolling != NAIVE_FREE) rolling_law(&n->laws, dt, &c, h, &n->count);
    a->force = plus(plus(a->force, -c.F, c.n), 1, c.T);
    b->force = plus(plus(b->force, c.F, c.n), -1, c.T);
    a->torque = plus(plus(a->torque, la, cross(c.n, c.T)), 1, c.M);
    b->torque = plus(plus(b->torque, lb, cross(c.n, c.T)), -1, c.M);
    n->count.began += began; n->count.attracted += c.F < 0;
    n->count.across += far_image; n->count.walls += j >= NAIVE_BODIES;
}
static void forces(naive *n, double dt) {
    int i, j;
    for (i = 0; i < n->bodies; i++) n->body[i].force = n->body[i].torque = vec(0, 0, 0);
    for (i = 0; i < n->bodies; i++) {
        const int still = n->body[i].fixed;                    /* nothing acts between two that cannot move */
        for (j = i + 1; j < n->bodies; j++) if (!still || !n->body[j].fixed) touch(n, i, j, dt);
        for (j = 0; j < n->planes; j++) if (!still) touch(n, i, NAIVE_BODIES + j, dt);
    }
}

/* ---- velocity Verlet ---- */
void naive_step(naive *n, int steps) {
    const double dt = n->laws.dt;
    int i, k;
    if (!n->started) forces(n, 0);
    n->started = 1;
    for (k = 0; k < steps; k++) {
        for (i = 0; i < n->bodies; i++) {
            naive_body *b = &n->body[i];
            const naive_vec a = plus(n->laws.gravity, 1/b->m, b->force), alpha = times(1/b->I, b->torque);
            if (b->fixed) continue;
            b->v_half = plus(b->v, dt/2, a);
            b->w_half = plus(b->w, dt/2, alpha);
            b->x = plus(b->x, dt, b->v_half);
            b->v = plus(b->v_half, dt/2, a);           /* predicted: the acceleration of the step before */
            b->w = plus(b->w_half, dt/2, alpha);
        }
        forces(n, dt);
        for (i = 0; i < n->bodies; i++) {
            naive_body *b = &n->body[i];
            if (b->fixed) continue;
            b->v = plus(b->v_half, dt/2, plus(n->laws.gravity, 1/b->m, b->force));
            b->w = plus(b->w_half, dt/2/b->I, b->torque);
        }
    }
}

/* ---- the scene ---- */
naive *naive_create(const naive_laws *laws) {
    naive *n = (naive *)calloc(1, sizeof *n);
    if (n) n->laws = *laws;
    return n;
}
void naive_free(naive *n) { free(n); }
int naive_material_add(naive *n, const naive_material *material) {
    int i;
    if (n->materials == NAIVE_MATERIALS) return -1;
    n->material[n->materials] = *material;
    for (i = 0; i <= n->materials; i++) naive_pair_set(n, i, n->materials, mixed(&n->material[i], material));
    return n->materials++;
}
naive_pair naive_pair_get(const naive *n, int a, int b) { return n->pair[a][b]; }
void naive_pair_set(naive *n, int a, int b, naive_pair pair) { n->pair[a][b] = n->pair[b][a] = pair; }
int naive_sphere_add(naive *n, int material, double radius, naive_vec x, naive_vec v, naive_vec spin, int fixed) {
    naive_body *b = &n->body[n->bodies];
    if (n->bodies == NAIVE_BODIES) return -1;
    b->material = material; b->fixed = fixed; b->R = radius;
    b->m = 4.0/3*naive_pi*radius*radius*radius*n->material[material].density;
    b->I = 2.0/5*b->m*radius*radius;
    b->x = x;
    if (!fixed) { b->v = v; b->w = spin; }
    return n->bodies++;
}
int naive_plane_add(naive *n, int material, naive_vec point, naive_vec normal) {
    const naive_plane plane = {material, point, times(1/size(normal), normal)};
    if (n->planes == NAIVE_PLANES) return -1;
    n->plane[n->planes] = plane;
    return n->planes++;
}
naive_state naive_get(const naive *n, int body) {
    const naive_body *b = &n->body[body];
    naive_state s;
    s.x = b->x; s.v = b->v; s.spin = b->w;
    s.force = b->force; s.torque = b->torque; s.mass = b->m;
    return s;
}
naive_count naive_counts(const naive *n) { return n->count; }
