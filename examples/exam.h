/* exam.h - an exam for contact laws: is the force finite, the same from both sides and in every frame? Does the law create
   no energy, and is it stable at the advised step? MIT licence. Include it after dem.h.

       exam e = exam_of("my law", my_law, 0, 3, 1, 1e5);   // user data, reals of memory, vectors, N/m
       exam_sheet sheet;
       exam_take(&e, &sheet);
       exam_print(&sheet, stdout);                         // one line per property: passed, or the mistake found

   The exam moves a contact along paths of overlap, slip and rolling (exam_begin, exam_move), and it runs worlds of two
   grains that collide. exam.c draws the curves of a law as a page; tests/examples/test_exam.c has a wrong law for every line.
   docs/laws.md explains what a law that fails a line does to a scene. */
#ifndef EXAM_H
#define EXAM_H
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

/* A law and the conditions of its exam; comments give the defaults after a colon. exam_of fills it in; change what you like
   before exam_take. */
typedef struct exam {
    const char *name;
    dem_law_fn law;
    void *user;                  /* handed to the law as c->user                              */
    int memory, vectors;         /* as law_memory and law_vectors of the world desc           */
    double stiffness;            /* N/m, as law_stiffness; 0: built-in                        */
    double range;                /* m, as law_range: 0                                        */
    int who;                     /* as law_who; the grains then carry eight numbers, zeros: 0 */
    dem_contact_fn made;         /* for laws of bonds: makes a bond, as for dem_bonds_make, with the world as user: null */
    double radius;               /* m, of both grains: 1e-3                                   */
    double deep;                 /* largest overlap of the paths, of the radius: 0.02         */
    double speed;                /* m/s, of impacts: 0.1                                      */
    dem_normal_law coefficients; /* kn, cn, kt, ct of the contact are those of this built-in law: Hertz */
    dem_material_desc material;  /* glass, softened: 2500 kg/m3, 1e7 Pa, friction 0.4, rolling friction 0.1 */
    void (*tell)(int line);      /* called before each line, and with EXAM_LINES at the end: null */
    dem_contact contact;         /* two such grains as a law sees them: set by exam_take      */
    dem_real bond[DEM_LAW_MEMORY];   /* what `made` writes into their memory: set by exam_take */
} exam;

enum { EXAM_FINITE, EXAM_PURE, EXAM_ASKED, EXAM_SWAP, EXAM_FRAME, EXAM_TURN, EXAM_WAY, EXAM_BOUND, EXAM_ENDS, EXAM_PRESS,
       EXAM_SHEAR, EXAM_ROLL, EXAM_MIXED, EXAM_IMPACT, EXAM_STEP, EXAM_ORDER, EXAM_COST, EXAM_LINES };
typedef struct exam_line {
    const char *asks;            /* the property that the line checks                         */
    int passed;
    char found[280];             /* the figure, or the mistake and where to look for it       */
} exam_line;
typedef struct exam_sheet {
    const char *name;
    int passed;                  /* number of lines passed                                    */
    exam_line line[EXAM_LINES];
} exam_sheet;

static inline exam exam_of(const char *name, dem_law_fn law, void *user, int memory, int vectors, double stiffness) {
    const dem_material_desc zero = DEM_MATERIAL_DESC;
    exam e;
    memset(&e, 0, sizeof e);
    e.name = name; e.law = law; e.user = user; e.memory = memory; e.vectors = vectors; e.stiffness = stiffness;
    e.radius = 1e-3;
    e.deep = 0.02;
    e.speed = 0.1;
    e.material = zero;
    e.material.density = 2500;
    e.material.young = DEM_R(1e7);
    e.material.poisson = DEM_R(0.25);
    e.material.restitution = DEM_R(0.7);
    e.material.friction = DEM_R(0.4);
    e.material.rolling_friction = DEM_R(0.1);
    return e;
}

/* ---- worlds of two grains ---- */

/* The impact of two grains. */
typedef struct exam_impact {
    double speed, angle;         /* m/s, relative; rad, from the line of centres              */
    double step;                 /* time step over the advised one; < 0: over the largest allowed */
    double early;                /* steps before they touch                                   */
    /* results */
    double energy;               /* after, over before; below 0: the run failed               */
    double normal, slip, spin;   /* m/s, relative, as they part; m/s, radius times spin       */
    char error[160];
} exam_impact;

static inline dem_world *exam_world(const exam *e, dem_law_fn law, void *user, double speed, double dt) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.threads = 1;
    desc.law = law;
    desc.law_user = user;
    desc.law_memory = e->memory;
    desc.law_vectors = e->vectors;
    desc.law_stiffness = (dem_real)e->stiffness;
    desc.law_range = (dem_real)e->range;
    desc.law_who = e->who;
    desc.body_reals = e->who ? "n1 n2 n3 n4 n5 n6 n7 n8" : 0;
    desc.normal_law = e->coefficients;
    desc.impact_speed = (dem_real)speed;
    desc.dt = (dem_real)dt;
    desc.allow_large_dt = 1;
    return dem_world_create(&desc);
}
/* Returns the gap between two grains, m. */
static inline double exam_gap(const dem_world *world, dem_body one, dem_body other, double radius) {
    dem_body_state a, b;
    double x, y, z;
    if (dem_body_get(world, one, &a) != DEM_OK || dem_body_get(world, other, &b) != DEM_OK) return 0;
    x = (double)(b.position.x - a.position.x);
    y = (double)(b.position.y - a.position.y);
    z = (double)(b.position.z - a.position.z);
    return sqrt(x*x + y*y + z*z) - 2*radius;
}
/* Makes the bond of two grains, and keeps a copy of its history. */
typedef struct exam_bond { const exam *e; dem_world *world; dem_real memory[DEM_LAW_MEMORY]; } exam_bond;
static inline void exam_make(const dem_contact_info *c, dem_real *memory, void *user) {
    exam_bond *b = (exam_bond *)user;
    b->e->made(c, memory, b->world);
    memcpy(b->memory, memory, (size_t)b->e->memory*sizeof *memory);
}
static inline int exam_join(const exam *e, dem_world *world, exam_bond *b) {
    memset(b, 0, sizeof *b);
    b->e = e;
    b->world = world;
    return dem_bonds_make(world, (dem_real)(0.5*e->range), exam_make, b) == 1;
}
/* Runs one impact to its end. Bonded grains, which do not separate, run for 20 contact times. */
static inline void exam_collide(const exam *e, exam_impact *m) {
    dem_advice advice;
    dem_totals before, after;
    dem_body_state a, b;
    dem_body one, other;
    dem_world *world = 0;
    exam_bond bond;
    double dt = 1, energy;
    int pass, met = 0;
    long k, most;
    m->energy = -1;
    m->error[0] = 0;
    advice.contact_time = 0;
    for (pass = 0; pass < 2; pass++) {           /* the second pass has the step that the first one found */
        const double apart = e->made ? 0 : 0.5*e->range;
        const double early = pass && !e->made ? 0.5*m->speed*m->early*dt*cos(m->angle) : 0;
        const double x = e->radius + apart + early, y = apart*tan(m->angle);    /* over the range to the line of centres */
        dem_material stuff;
        dem_world_destroy(world);
        world = exam_world(e, e->law, e->user, m->speed, pass ? dt : 0);
        if (!world) { snprintf(m->error, sizeof m->error, "the world desc is refused: look at memory, vectors and "
                               "stiffness"); return; }
        stuff = dem_material_add(world, &e->material);
        one = dem_sphere_add(world, stuff, (dem_real)e->radius, dem_vec3_make((dem_real)-x, (dem_real)-y, 0));
        other = dem_sphere_add(world, stuff, (dem_real)e->radius, dem_vec3_make((dem_real)x, (dem_real)y, 0));
        if (dem_body_get(world, one, &a) != DEM_OK || dem_body_get(world, other, &b) != DEM_OK ||
            dem_step_advice_get(world, &advice) != DEM_OK) break;
        dt = m->step < 0 ? -m->step*(double)advice.dt_max : m->step*(double)advice.dt;
    }
    a.velocity = dem_vec3_make((dem_real)(m->speed/2*cos(m->angle)), (dem_real)(m->speed/2*sin(m->angle)), 0);
    b.velocity = dem_vec3_make(-a.velocity.x, -a.velocity.y, 0);
    dem_body_set(world, one, &a);
    dem_body_set(world, other, &b);
    before = dem_totals_get(world);
    if (e->made && !exam_join(e, world, &bond))
        snprintf(m->error, sizeof m->error, "dem_bonds_make makes no bond: %.100s", dem_world_error_get(world));
    /* time for the way through the range and back, at a lower speed than before the impact */
    most = e->made ? (long)floor(20*(double)advice.contact_time/dt + 0.5)
        : (long)((40*(double)advice.contact_time + 6*e->range/(m->speed*cos(m->angle)))/dt + 2*m->early + 100);
    for (k = 0; k < most; k++) {
        const dem_result result = dem_world_step(world, 1);
        const int near_by = exam_gap(world, one, other, e->radius) < e->range;
        met |= near_by;                          /* the law is called; it may separate the grains before they touch */
        if (result != DEM_OK || (met && !near_by && !e->made)) break;
    }
    after = dem_totals_get(world);
    energy = (after.kinetic + after.rotational)/(before.kinetic + before.rotational);
    if (!m->error[0]) snprintf(m->error, sizeof m->error, "%.150s", dem_world_error_get(world));
    dem_body_get(world, one, &a);
    dem_body_get(world, other, &b);
    m->normal = (double)(b.velocity.x - a.velocity.x);
    m->slip = (double)(b.velocity.y - a.velocity.y);
    m->spin = e->radius*(double)(a.spin.z + b.spin.z);
    if (met && energy >= 0 && energy < 1e30 && !m->error[0]) m->energy = energy;
    else if (!m->error[0]) snprintf(m->error, sizeof m->error, met ? "energy is not a number"
                                    : "they did not come within %g m of each other", e->range);
    dem_world_destroy(world);
}
/* A law without force that copies the contact as a world passes it. */
static inline void exam_look(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    (void)memory; (void)f;
    *(dem_contact *)c->user = *c;
}
/* The numbers of the grains on paths, which are zeros, and their rates, which are not used. */
static inline dem_real *exam_reals(void) {
    static dem_real reals[2*DEM_BODY_REALS];
    return reals;
}
static inline int exam_contact(exam *e) {
    dem_world *world = exam_world(e, exam_look, &e->contact, e->speed, 1e-9);
    dem_material stuff;
    int joined = 1;
    if (!world) return 0;
    stuff = dem_material_add(world, &e->material);
    memset(&e->contact, 0, sizeof e->contact);
    dem_sphere_add(world, stuff, (dem_real)e->radius, dem_vec3_make(0, 0, 0));
    dem_sphere_add(world, stuff, (dem_real)e->radius, dem_vec3_make(0, 0, (dem_real)(1.99*e->radius)));
    dem_world_step(world, 1);
    dem_world_destroy(world);
    if (e->made) {
        exam_bond bond;
        world = exam_world(e, e->law, e->user, e->speed, 1e-9);
        stuff = dem_material_add(world, &e->material);
        dem_sphere_add(world, stuff, (dem_real)e->radius, dem_vec3_make(0, 0, 0));
        dem_sphere_add(world, stuff, (dem_real)e->radius, dem_vec3_make(0, 0, (dem_real)(2*e->radius)));
        joined = exam_join(e, world, &bond);
        memcpy(e->bond, bond.memory, sizeof e->bond);
        dem_world_destroy(world);
    }
    e->contact.user = e->user;
    e->contact.who.reals_a = e->contact.who.reals_b = exam_reals();
    e->contact.who.rate_a = e->contact.who.rate_b = exam_reals() + DEM_BODY_REALS;
    return joined && e->contact.overlap > 0;
}
/* The overlap (m) at which paths begin: at the range, for a bond at touch; and the overlap at which they end: a bond is
   stretched, but does not break. */
static inline double exam_first(const exam *e) { return e->made ? 0 : -e->range; }
static inline double exam_last(const exam *e) { return e->made ? -0.25*e->range : -e->range; }

/* ---- paths: the exam moves the contact ---- */

enum { EXAM_CANARY = 8 };        /* reals behind the law's memory, which it must not touch     */
typedef struct exam_path {
    const exam *e;
    dem_contact c;
    dem_contact_force f;         /* the last force; zeros while the two are apart             */
    dem_real memory[DEM_LAW_MEMORY + EXAM_CANARY];
    dem_quat frame;              /* the path's frame in the world's                           */
    int swapped;                 /* 1: a and b are exchanged                                  */
    int halted;                  /* 1: slip and spin are 0 at the end of each step, but not in its mean */
    double work, largest;        /* J, done on the contact since exam_begin; N, largest |force| */
} exam_path;
/* One step along a path, in its frame (normal z): the overlap at its end (m), slip (m/s), spin (rad/s), rotation of the
   normal (1/s) and of the contact plane about it (rad/s). */
typedef struct exam_go { double overlap, slip[2], spin[3], rate[2], twist; } exam_go;

static inline void exam_begin(exam_path *p, const exam *e) {
    int k;
    memset(p, 0, sizeof *p);
    p->e = e;
    p->frame = dem_quat_make(1, 0, 0, 0);
    for (k = 0; k < EXAM_CANARY; k++) p->memory[e->memory + k] = DEM_R(1.25)*(dem_real)(k + 1);
    if (e->made) memcpy(p->memory, e->bond, (size_t)e->memory*sizeof *p->memory);
    p->c = e->contact;
    p->c.overlap = (dem_real)exam_first(e);
}
static inline double exam_dot(dem_vec3 a, dem_vec3 b) { return (double)(a.x*b.x + a.y*b.y + a.z*b.z); }
static inline dem_vec3 exam_turned(const exam_path *p, double x, double y, double z) {
    const double s = p->swapped ? -1 : 1;
    return dem_quat_rotate(p->frame, dem_vec3_make((dem_real)(s*x), (dem_real)(s*y), (dem_real)(s*z)));
}
/* Calls the law for a step of dt (s); 0: for the force only. Updates the history, but not the overlap of the path. */
static inline dem_contact_force exam_ask(exam_path *p, const exam_go *to, double dt, double closing) {
    dem_contact_force f;
    dem_contact *c = &p->c;
    c->normal = exam_turned(p, 0, 0, 1);
    c->slip = c->slip_step = exam_turned(p, to->slip[0], to->slip[1], 0);
    c->spin = c->spin_step = exam_turned(p, to->spin[0], to->spin[1], to->spin[2]);
    if (p->halted) c->slip = c->spin = dem_vec3_make(0, 0, 0);
    c->normal_rate = exam_turned(p, to->rate[0], to->rate[1], 0);
    c->twist = (dem_real)(p->swapped ? -to->twist : to->twist);
    c->overlap = (dem_real)to->overlap;
    c->closing_speed = (dem_real)closing;
    c->dt = (dem_real)dt;
    memset(&f, 0, sizeof f);
    p->e->law(c, p->memory, &f);
    return f;
}
static inline void exam_move(exam_path *p, const exam_go *to, double dt) {
    const dem_contact_force was = p->f;
    const double from = (double)p->c.overlap, closing = dt > 0 ? (to->overlap - from)/dt : 0;
    const dem_vec3 slip = exam_turned(p, to->slip[0], to->slip[1], 0);
    const dem_vec3 spin = exam_turned(p, to->spin[0], to->spin[1], to->spin[2]);
    int k;
    if (!(to->overlap > -p->e->range)) {
        memset(&p->f, 0, sizeof p->f);
        for (k = 0; k < p->e->memory; k++) p->memory[k] = 0;
        p->c.overlap = (dem_real)-p->e->range;
    } else p->f = exam_ask(p, to, dt, closing);
    p->work += 0.5*((double)(p->f.normal + was.normal)*(to->overlap - from) -
                    (exam_dot(p->f.tangent, slip) + exam_dot(was.tangent, slip) + exam_dot(p->f.moment, spin) +
                     exam_dot(was.moment, spin))*dt);
    p->largest = fmax(p->largest, fmax(fabs((double)p->f.normal), sqrt(exam_dot(p->f.tangent, p->f.tangent))));
}
/* Moves to this overlap in `steps` equal steps, with slip x, y (m) and rolling by these angles (rad) on the way. `speed` (m/s)
   is that of the longest of these motions. */
static inline void exam_go_on(exam_path *p, double overlap, double x, double y, double roll, double spin, int steps,
                              double speed) {
    const double from = (double)p->c.overlap, r = p->e->radius;
    const double way = fmax(fmax(fabs(overlap - from), sqrt(x*x + y*y)), fmax(fabs(roll), fabs(spin))*r);
    const double seconds = way/speed;
    exam_go to;
    int k;
    memset(&to, 0, sizeof to);
    if (!(seconds > 0)) return;
    to.slip[0] = x/seconds; to.slip[1] = y/seconds;
    to.spin[0] = roll/seconds; to.spin[2] = spin/seconds;
    for (k = 1; k <= steps; k++) {
        to.overlap = from + (overlap - from)*k/steps;
        exam_move(p, &to, seconds/steps);
    }
}
static inline double exam_random(unsigned *seed) {       /* -1 .. 1 */
    *seed = *seed*1664525u + 1013904223u;
    return (*seed >> 8)/8388608.0 - 1;
}
/* Step k of a random path: loading and unloading, slip, rolling, rotation. */
static inline exam_go exam_stray(const exam *e, int k, unsigned *seed) {
    const double v = e->speed, w = v/e->radius;
    exam_go to;
    to.overlap = e->radius*e->deep*(0.6 + 0.4*sin(0.1*k) + 0.05*exam_random(seed));
    to.slip[0] = v*exam_random(seed); to.slip[1] = v*exam_random(seed);
    to.spin[0] = w*exam_random(seed); to.spin[1] = w*exam_random(seed); to.spin[2] = w*exam_random(seed);
    to.rate[0] = w*exam_random(seed); to.rate[1] = w*exam_random(seed);
    to.twist = w*exam_random(seed);
    return to;
}
static inline double exam_dt(const exam *e) { return e->deep*e->radius/e->speed/100; }
static inline double exam_apart(dem_vec3 a, dem_vec3 b) {
    const dem_vec3 d = dem_vec3_make(a.x - b.x, a.y - b.y, a.z - b.z);
    return sqrt(exam_dot(d, d));
}

/* ---- the lines: each function returns 1 if the law passes, and writes the figure or the mistake ---- */

#define EXAM_SAY(...) snprintf(found, 280, __VA_ARGS__)
static inline int exam_sound(double x) { return x > -1e300 && x < 1e300 && (sizeof(dem_real) > 4 || fabs(x) < 3e38); }
static inline int exam_finite_force(const dem_contact_force *f) {
    return exam_sound((double)f->normal) && exam_sound(exam_dot(f->tangent, f->tangent)) &&
           exam_sound(exam_dot(f->moment, f->moment));
}
/* Inputs of 20 decades: overlaps down to 1e-20 radii, speeds from 1e-10 to 1e10 m/s. */
static inline int exam_is_finite(const exam *e, char *found) {
    int i, j, k, n, count = 0;
    for (i = -20; i <= 0; i++)
        for (j = -10; j <= 10; j += 2)
            for (k = -10; k <= 10; k += 2)
                for (n = 0; n < (e->range > 0 ? 8 : 4); n++) {
                    const double slip = n & 1 ? 0 : pow(10, k), closing = (n & 2 ? -1 : 1)*pow(10, j);
                    exam_path p;
                    exam_go to;
                    dem_contact_force f;
                    int again;
                    memset(&to, 0, sizeof to);
                    exam_begin(&p, e);
                    to.overlap = n < 4 ? e->radius*pow(10, i) : -0.99*e->range*pow(10, i);
                    to.slip[0] = slip;
                    to.spin[1] = slip/e->radius;
                    for (again = 0; again < 2; again++, count++) {
                        f = exam_ask(&p, &to, exam_dt(e), closing);
                        if (exam_finite_force(&f)) continue;
                        EXAM_SAY("no number at an overlap of %g m, closing at %g m/s, slipping at %g m/s%s: look for a "
                                 "quotient or a root of what may be 0 or below", to.overlap, closing, slip,
                                 again ? ", the second step" : "");
                        return 0;
                    }
                }
    EXAM_SAY("%d inputs", count);
    return 1;
}
/* The same contact, once alone and once with another contact in between. */
static inline int exam_is_pure(const exam *e, char *found) {
    exam_path alone, one, other;
    unsigned seed = 1, again = 1, elsewhere = 2;
    dem_contact_force told[200];
    int k;
    exam_begin(&alone, e); exam_begin(&one, e); exam_begin(&other, e);
    for (k = 0; k < 200; k++) {
        const exam_go to = exam_stray(e, k, &seed);
        exam_move(&alone, &to, exam_dt(e));
        told[k] = alone.f;
    }
    for (k = 0; k < 200; k++) {
        const exam_go to = exam_stray(e, k, &again), stray = exam_stray(e, 7*k, &elsewhere);
        exam_move(&one, &to, exam_dt(e));
        exam_move(&other, &stray, exam_dt(e));
        if (told[k].normal < one.f.normal || told[k].normal > one.f.normal ||
            exam_apart(told[k].tangent, one.f.tangent) > 0 || exam_apart(told[k].moment, one.f.moment) > 0) {
            EXAM_SAY("the same contact answers %g N, then %g N when another one is asked in between (step %d): the law "
                     "remembers beside its memory: static variables? random numbers?", (double)told[k].normal,
                     (double)one.f.normal, k);
            return 0;
        }
    }
    EXAM_SAY("the same bits, alone or among others");
    return 1;
}
static inline int exam_is_asked(const exam *e, char *found) {
    exam_path p;
    unsigned seed = 3;
    int k, i;
    exam_begin(&p, e);
    for (k = 0; k < 200; k++) {
        const exam_go to = exam_stray(e, k, &seed);
        exam_path was;
        exam_move(&p, &to, exam_dt(e));
        was = p;
        exam_ask(&p, &to, 0, 0);
        for (i = 0; i < e->memory; i++)
            if (p.memory[i] < was.memory[i] || p.memory[i] > was.memory[i]) {
                EXAM_SAY("real %d of the memory goes from %g to %g when dt is 0: with dt = 0 dem.h only asks for the "
                         "force: change memory only if c->dt > 0", i, (double)was.memory[i], (double)p.memory[i]);
                return 0;
            }
        for (i = 0; i < EXAM_CANARY; i++)
            if (p.memory[e->memory + i] < DEM_R(1.25)*(dem_real)(i + 1) ||
                p.memory[e->memory + i] > DEM_R(1.25)*(dem_real)(i + 1)) {
                EXAM_SAY("real %d is written, but law_memory is %d: declare as many as the law uses", e->memory + i,
                         e->memory);
                return 0;
            }
    }
    EXAM_SAY("%d reals, written only in a step", e->memory);
    return 1;
}
/* Follows two equal paths, the second with a and b exchanged or in another frame. Returns the largest difference of forces
   over the largest force. */
static inline double exam_beside(const exam *e, exam_path *p, exam_path *q, int first, int last, unsigned *seed, int back) {
    double apart = 0;
    int k;
    for (k = first; k < last; k++) {
        const exam_go to = exam_stray(e, k, seed);
        dem_vec3 t, m;
        exam_move(p, &to, exam_dt(e));
        exam_move(q, &to, exam_dt(e));
        t = q->f.tangent; m = q->f.moment;
        if (back) { t = dem_quat_unrotate(q->frame, t); m = dem_quat_unrotate(q->frame, m); }
        if (q->swapped) { t = dem_vec3_make(-t.x, -t.y, -t.z); m = dem_vec3_make(-m.x, -m.y, -m.z); }
        apart = fmax(apart, fabs((double)(p->f.normal - q->f.normal)));
        apart = fmax(apart, fmax(exam_apart(p->f.tangent, t), exam_apart(p->f.moment, m)/e->radius));
    }
    return apart/(p->largest + 1e-300);
}
static inline double exam_rounding(void) { return sizeof(dem_real) > 4 ? 1e-9 : 5e-5; }
static inline int exam_is_swapped(const exam *e, char *found) {
    exam_path p, q;
    unsigned seed = 5;
    double apart;
    int k;
    exam_begin(&p, e); exam_begin(&q, e);
    q.swapped = 1;
    apart = exam_beside(e, &p, &q, 0, 100, &seed, 0);
    if (apart > exam_rounding()) {
        EXAM_SAY("a and b exchanged, forces differ by %.2g of the largest: does the law look at material_a alone, or at "
                 "directions of the world?", apart);
        return 0;
    }
    q = p;                                       /* a and b are exchanged during the contact, as lists do it */
    q.swapped = 1;
    for (k = 0; k < 3*e->vectors; k++) q.memory[k] = -q.memory[k];
    apart = exam_beside(e, &p, &q, 100, 200, &seed, 0);
    EXAM_SAY("%.1g of the largest force", apart);
    if (apart <= exam_rounding()) return 1;
    EXAM_SAY("a and b exchanged in mid-contact, forces differ by %.2g of the largest: put vectors first in the memory and "
             "say in law_vectors how many they are (%d now)", apart, e->vectors);
    return 0;
}
static inline int exam_is_turned(const exam *e, char *found) {
    double worst = 0;
    unsigned seed = 7;
    int n;
    for (n = 0; n < 4; n++) {
        exam_path p, q;
        double a[4], size = 0;
        int k;
        for (k = 0; k < 4; k++) { a[k] = exam_random(&seed); size += a[k]*a[k]; }
        exam_begin(&p, e); exam_begin(&q, e);
        size = 1/sqrt(size);
        q.frame = dem_quat_make((dem_real)(a[0]*size), (dem_real)(a[1]*size), (dem_real)(a[2]*size), (dem_real)(a[3]*size));
        worst = fmax(worst, exam_beside(e, &p, &q, 0, 100, &seed, 1));
    }
    EXAM_SAY("%.1g of the largest force", worst);
    if (worst <= exam_rounding()) return 1;
    EXAM_SAY("seen from a frame that is turned, forces differ by %.2g of the largest: components x, y, z are used where "
             "only normal, slip, spin and their products may be", worst);
    return 0;
}
/* Presses, slips and rolls a little, so that springs are stretched and nothing slides. */
static inline void exam_stretch(exam_path *p) {
    const double deep = p->e->deep*p->e->radius, slow = 1e-5*p->e->speed;
    exam_go_on(p, deep, 0, 0, 0, 0, 100, slow);
    exam_go_on(p, deep, 0.02*deep, 0.01*deep, 0, 0, 100, slow);
    exam_go_on(p, deep, 0, 0, 1e-4, 0, 100, slow);
}
/* Returns the largest difference of tangential forces and moments, over the largest of them. */
static inline double exam_sideways(const exam_path *p, dem_vec3 tangent, dem_vec3 moment) {
    const double r = p->e->radius, t = sqrt(exam_dot(p->f.tangent, p->f.tangent));
    const double size = fmax(t, sqrt(exam_dot(p->f.moment, p->f.moment))/r);
    return fmax(exam_apart(p->f.tangent, tangent), exam_apart(p->f.moment, moment)/r)/(size + 1e-6*p->largest + 1e-300);
}
/* Two grains that touch rotate together by 1.5 rad about an oblique axis: their springs rotate with them. */
static inline int exam_is_carried(const exam *e, char *found) {
    enum { STEPS = 400 };
    double worst = 0;
    unsigned seed = 11;
    int n, k;
    for (n = 0; n < 4; n++) {
        const double dt = 0.01*e->deep*e->radius/(1e-5*e->speed), half = 0.75/(int)STEPS;
        double a[3], size = 0;
        exam_path p, q;
        exam_go still, turn;
        dem_quat by;
        dem_vec3 was;
        for (k = 0; k < 3; k++) { a[k] = exam_random(&seed); size += a[k]*a[k]; }
        size = 1/sqrt(size);
        exam_begin(&p, e); exam_begin(&q, e);
        exam_stretch(&p); exam_stretch(&q);
        by = dem_quat_make((dem_real)cos(half), (dem_real)(sin(half)*a[0]*size), (dem_real)(sin(half)*a[1]*size),
                           (dem_real)(sin(half)*a[2]*size));
        was = dem_quat_unrotate(by, dem_vec3_make(0, 0, 1));     /* the normal before a step, in the frame after it */
        memset(&still, 0, sizeof still);
        still.overlap = e->deep*e->radius;
        turn = still;
        turn.rate[0] = -(double)was.x/dt; turn.rate[1] = -(double)was.y/dt;
        turn.twist = 2*half*a[2]*size/dt;
        for (k = 0; k < STEPS; k++) {
            q.frame = dem_quat_multiply(q.frame, by);
            exam_move(&p, &still, dt);
            exam_move(&q, &turn, dt);
        }
        worst = fmax(worst, exam_sideways(&p, dem_quat_unrotate(q.frame, q.f.tangent), dem_quat_unrotate(q.frame, q.f.moment)));
    }
    EXAM_SAY("%.1g of the tangential force", worst);
    if (worst <= 2e-3) return 1;
    EXAM_SAY("two grains rotate together, and the tangential force or moment lags by %.2g of itself: rotate vectors in the "
             "memory with dem_memory_rotate before they grow", worst);
    return 0;
}
/* Springs grow by the displacement of the step, slip_step dt, and not by the slip at its end. */
static inline int exam_is_displaced(const exam *e, char *found) {
    exam_path p, q;
    exam_go still;
    double apart;
    memset(&still, 0, sizeof still);
    still.overlap = e->deep*e->radius;
    exam_begin(&p, e); exam_begin(&q, e);
    q.halted = 1;
    exam_stretch(&p); exam_stretch(&q);
    p.f = exam_ask(&p, &still, 0, 0);
    q.f = exam_ask(&q, &still, 0, 0);
    apart = exam_sideways(&p, q.f.tangent, q.f.moment);
    EXAM_SAY("%.1g of the tangential force", apart);
    if (apart <= 1e-3) return 1;
    EXAM_SAY("with the same slip_step and spin_step, but no slip and spin at the end of steps, the springs differ by %.2g of "
             "their force: memory must grow by slip_step and spin_step", apart);
    return 0;
}
/* Slides by a radius at a steady overlap. */
static inline int exam_is_bounded(const exam *e, char *found) {
    exam_path p;
    double ratio;
    if (e->made) { EXAM_SAY("not asked of bonds"); return 1; }
    exam_begin(&p, e);
    exam_go_on(&p, e->deep*e->radius, 0, 0, 0, 0, 100, 1e-5*e->speed);
    exam_go_on(&p, e->deep*e->radius, e->radius, 0, 0, 0, 4000, 1e-5*e->speed);
    ratio = sqrt(exam_dot(p.f.tangent, p.f.tangent))/(fabs((double)p.f.normal) + 1e-300);
    EXAM_SAY("%.2g of the normal force after a slip of one radius", ratio);
    if (ratio <= 10) return 1;
    EXAM_SAY("after a slip of one radius the tangential force is %.2g times the normal force: limit it, by Coulomb to "
             "friction times the normal force, and shorten the spring with it", ratio);
    return 0;
}
/* Slow loading and unloading, through the range: does the force begin and end at 0, without a jump? */
static inline int exam_is_smooth(const exam *e, char *found) {
    const double deep = e->deep*e->radius, slow = 1e-6*e->speed;
    const char *where = "";
    exam_path p;
    double jump = 0, at = 0, before = 0;
    int k, part;
    exam_begin(&p, e);
    for (part = 0; part < 2; part++)
        for (k = 1; k <= 1000; k++) {
            const double from = part ? deep : exam_first(e), end = part ? exam_last(e) : deep;
            const double overlap = from + (end - from)*k/1000, least = 1e-9*(deep + e->range) - e->range;
            exam_go to;
            memset(&to, 0, sizeof to);
            to.overlap = fmax(overlap, least);
            if (k == 1 && !part) {                /* the very first touch */
                exam_go first = to;
                first.overlap = fmax(exam_first(e), least);
                exam_move(&p, &first, 1e-9*deep/slow);
                before = (double)p.f.normal;
                jump = fabs(before);
                where = "at the first touch";
            }
            exam_move(&p, &to, deep/1000/slow);
            if (fabs((double)p.f.normal - before) > jump) {
                jump = fabs((double)p.f.normal - before);
                where = part ? "on the way out" : "on the way in";
                at = overlap;
            }
            before = (double)p.f.normal;
        }
    if (!e->made && fabs(before) > jump) { jump = fabs(before); where = "as the two part"; at = 0; }
    EXAM_SAY("largest step of 1000: %.1g of the largest force", jump/(p.largest + 1e-300));
    if (jump <= 0.05*p.largest) return 1;
    EXAM_SAY("the force jumps by %.2g of its maximum %s, at an overlap of %.2g radii, although the grains move slowly: no time "
             "step resolves a jump", jump/p.largest, where, at/e->radius);
    return 0;
}
/* A closed loop must not create energy. exam_gain returns its gain over the energy put in. */
static inline double exam_gain(const exam_path *p, double before, double in) { return (before - p->work)/(in + 1e-300); }
static inline int exam_gains(const char *what, double gain, const char *look, char *found) {
    EXAM_SAY("%s create %.1g of the energy put in", what, gain > 0 ? gain : 0);
    if (gain <= 2e-3) return 1;
    EXAM_SAY("%s create %.2g times the energy put in: %s", what, gain, look);
    return 0;
}
static inline int exam_is_pressed(const exam *e, char *found) {
    const double deep = e->deep*e->radius;
    double worst = 0, slow = 0;                  /* slow: springs alone */
    int fast, k;
    for (fast = 0; fast < 2; fast++) {
        const double speed = fast ? e->speed : 1e-6*e->speed;
        exam_path p;
        double in, before;
        exam_begin(&p, e);
        exam_go_on(&p, deep, 0, 0, 0, 0, 4000, speed);
        in = fabs(p.work);
        for (k = 0; k < 4; k++) {                /* unload partly and load again */
            before = p.work;
            exam_go_on(&p, deep*(0.2 + 0.2*k), 0, 0, 0, 0, 400, speed);
            exam_go_on(&p, deep, 0, 0, 0, 0, 400, speed);
            worst = fmax(worst, exam_gain(&p, before, in));
        }
        exam_go_on(&p, exam_last(e), 0, 0, 0, 0, 4000, speed);
        worst = fmax(worst, exam_gain(&p, 0, in));
        if (!fast) slow = worst;
    }
    return exam_gains("loops of loading, unloading and reloading", worst, slow > 2e-3
                      ? "the force on the way out must not lie above that on the way in"
                      : "a dashpot must act against the motion (+ cn times closing_speed)", found);
}
static inline int exam_is_sheared(const exam *e, char *found) {
    const double deep = e->deep*e->radius;
    double worst = 0;
    int n, k, round;
    for (n = 0; n < 6; n++) {                    /* slow: springs; fast: dashpots */
        const double u = n%3 == 0 ? 0.1*deep : n%3 == 1 ? deep : 20*deep, speed = (n < 3 ? 1e-5 : 1)*e->speed;
        for (round = 0; round < 2; round++) {
            exam_path p;
            double in = 0, before;
            exam_begin(&p, e);
            exam_go_on(&p, deep, 0, 0, 0, 0, 100, speed);
            for (k = 0; k < 3; k++) {
                before = p.work;
                if (round) {
                    exam_go_on(&p, deep, u, 0, 0, 0, 200, speed); exam_go_on(&p, deep, 0, u, 0, 0, 200, speed);
                    exam_go_on(&p, deep, -u, 0, 0, 0, 200, speed); exam_go_on(&p, deep, 0, -u, 0, 0, 200, speed);
                } else {
                    exam_go_on(&p, deep, u, 0, 0, 0, 200, speed); exam_go_on(&p, deep, -2*u, 0, 0, 0, 400, speed);
                    exam_go_on(&p, deep, u, 0, 0, 0, 200, speed);
                }
                in = sqrt(exam_dot(p.f.tangent, p.f.tangent))*u + fabs(p.work - before) + 1e-6*p.largest*u;
                /* the first loop leaves the spring stretched where it slid: its energy is stored, not lost */
                if (k) worst = fmax(worst, exam_gain(&p, before, in));
            }
        }
    }
    return exam_gains("loops of slip at a steady overlap", worst, "friction must act against slip (tangent is the force on a, "
                      "slip the velocity of a)", found);
}
static inline int exam_is_rolled(const exam *e, char *found) {
    const double deep = e->deep*e->radius;
    double worst = 0;
    int axis, n, k;
    for (axis = 0; axis < 2; axis++)
        for (n = 0; n < 4; n++) {
            const double angle = n%2 ? 0.5 : 1e-3, roll = axis ? 0 : angle, spin = axis ? angle : 0;
            const double speed = (n < 2 ? 1e-5 : 1)*e->speed;
            exam_path p;
            exam_begin(&p, e);
            exam_go_on(&p, deep, 0, 0, 0, 0, 100, speed);
            for (k = 0; k < 3; k++) {
                const double before = p.work;
                exam_go_on(&p, deep, 0, 0, roll, spin, 200, speed);
                exam_go_on(&p, deep, 0, 0, -2*roll, -2*spin, 400, speed);
                exam_go_on(&p, deep, 0, 0, roll, spin, 200, speed);
                if (k) worst = fmax(worst, exam_gain(&p, before, fabs(p.work - before)*0.5 +
                                                     1e-9*p.largest*e->radius*angle));
            }
        }
    return exam_gains("loops of rolling and twisting", worst, "the moment must act against the spin (moment is that on a, spin "
                      "that of a)", found);
}
/* Pressing while sheared, in either order: a spring whose stiffness follows the overlap may create energy. */
static inline int exam_is_mixed(const exam *e, char *found) {
    const double deep = e->deep*e->radius, u = 0.05*deep, speed = 1e-5*e->speed;
    double worst = 0;
    int order, k, sheared = 0;                   /* has the law a tangential force? */
    for (order = 0; order < 2; order++) {
        exam_path p;
        const double first = order ? 0.5*deep : deep, then = order ? deep : 0.5*deep;
        double in = 1e-300, stretched;
        exam_begin(&p, e);
        exam_go_on(&p, first, 0, 0, 0, 0, 200, speed);
        for (k = 0; k < 3; k++) {
            const double before = p.work;
            exam_go_on(&p, first, u, 0, 0, 0, 200, speed);
            stretched = p.work - before;
            sheared |= exam_dot(p.f.tangent, p.f.tangent) > 0;
            exam_go_on(&p, then, 0, 0, 0, 0, 200, speed);
            exam_go_on(&p, then, -u, 0, 0, 0, 200, speed);
            exam_go_on(&p, first, 0, 0, 0, 0, 200, speed);
            in = fmax(in, fabs(stretched) + 1e-6*p.largest*u);   /* for a law without shear: not only round-off */
            worst = fmax(worst, exam_gain(&p, before, in));
        }
    }
    if (!sheared && worst > 2e-3) {              /* compared with the energy put in, nearly 0, the figure says nothing */
        EXAM_SAY("the normal force alone creates energy: see \"no energy from pressing\"");
        return 0;
    }
    return exam_gains("loops of pressing while sheared", worst, "rescale the tangential force as the stiffness falls "
                      "(dem_law_mindlin_rescaled does)", found);
}
static inline int exam_is_bounced(const exam *e, char *found) {
    static const double speeds[3] = {0.1, 1, 10}, angles[4] = {0, 0.5, 1, 1.4};
    double worst = 0, most_speed = 0, most_angle = 0, least = 1e300, most = 0;
    int i, j;
    for (i = 0; i < 3; i++)
        for (j = 0; j < 4; j++) {
            exam_impact m;
            memset(&m, 0, sizeof m);
            m.speed = speeds[i]*e->speed; m.angle = angles[j]; m.step = 0.25; m.early = 2.5;
            exam_collide(e, &m);
            if (m.energy < 0) {
                EXAM_SAY("an impact at %g m/s, %.0f degrees, breaks the run: %.150s", m.speed, m.angle*57.29578, m.error);
                return 0;
            }
            if (!j) { least = fmin(least, m.normal/m.speed); most = fmax(most, m.normal/m.speed); }
            if (m.energy - 1 > worst) { worst = m.energy - 1; most_speed = m.speed; most_angle = m.angle; }
        }
    if (e->made) EXAM_SAY("none of 12 pairs that are bonded and pushed gains");
    else EXAM_SAY("restitution %.3f to %.3f head-on; none of 12 impacts gains", least, most);
    if (worst <= 1e-3) return 1;
    EXAM_SAY("an impact at %g m/s, %.0f degrees, ends with %.3g times the energy it began with: grains must not be pushed "
             "apart with more work than they were pushed together", most_speed, most_angle*57.29578, 1 + worst);
    return 0;
}
/* Returns the energy that impacts gain at this multiple of the largest allowed step. */
static inline double exam_gain_at(const exam *e, double step) {
    double worst = 0;
    int k;
    for (k = 0; k < 6; k++) {
        exam_impact m;
        memset(&m, 0, sizeof m);
        m.speed = e->speed; m.angle = 0.25*k; m.step = -step; m.early = 2 + k/6.0;
        exam_collide(e, &m);
        worst = fmax(worst, m.energy < 0 ? 1e300 : m.energy - 1);
    }
    return worst;
}
static inline int exam_is_stable(const exam *e, char *found) {
    double largest = 0, step, spring, dashpot, critical;
    exam_path p;
    exam_go at;
    memset(&at, 0, sizeof at);
    at.overlap = e->deep*e->radius;
    exam_begin(&p, e);
    dashpot = (double)exam_ask(&p, &at, 0, e->speed).normal;
    exam_begin(&p, e);
    spring = (double)exam_ask(&p, &at, 0, 0).normal;
    dashpot = (dashpot - spring)/e->speed;       /* N s/m */
    critical = 2*sqrt(fmax(spring, 0)/at.overlap*(double)e->contact.m_eff);
    for (step = 1; step < 100 && exam_gain_at(e, step) <= 0.02; step *= 1.5) largest = step;
    EXAM_SAY("impacts gain less than 2 %% up to %.1f times the largest allowed step", largest);
    if (largest > 0) return 1;
    for (step = 0.5; step > 1e-4 && exam_gain_at(e, step) > 0.02; step /= 2) {}
    if (step <= 1e-4) EXAM_SAY("impacts gain more than 2 %% at every step, the largest allowed one and 1e-4 of it: the cause is "
                               "the law and not the step");
    else if (dashpot > critical)
        EXAM_SAY("impacts gain more than 2 %% at the largest allowed step, less at %.2g of it: the dashpot (%.2g N s/m) limits "
                 "the step, for it is stronger than the critical one, 2 sqrt(k m) = %.2g N s/m: make it smaller", step, dashpot,
                 critical);
    else EXAM_SAY("impacts gain more than 2 %% at the largest allowed step, less at %.2g of it: law_stiffness (%g N/m) must be "
                  "the stiffest the law gets", step, e->stiffness);
    return 0;
}
/* Compares the outcome of an impact at dt/2, dt/4 and so on with that at dt/64, as a mean over 8 phases. Either the error
   is below a thousandth of the impact speed, or it falls with the step. */
static inline int exam_is_ordered(const exam *e, char *found) {
    double error[4] = {0, 0, 0, 0}, order;
    int phase, h;
    for (phase = 0; phase < 8; phase++) {
        exam_impact m[5];
        for (h = 4; h >= 0; h--) {
            memset(&m[h], 0, sizeof m[h]);
            m[h].speed = e->speed; m[h].angle = 0.6; m[h].early = 2 + phase/8.0;
            m[h].step = h == 4 ? 1/64.0 : 1/(double)(1 << h);
            exam_collide(e, &m[h]);
            if (m[h].energy < 0) { EXAM_SAY("an impact breaks the run: %.150s", m[h].error); return 0; }
            if (h < 4) error[h] += (fabs(m[h].normal - m[4].normal) + fabs(m[h].slip - m[4].slip) +
                                    fabs(m[h].spin - m[4].spin))/e->speed/8;
        }
    }
    order = log(error[0]/error[3])/log(8.0);
    EXAM_SAY("order %.1f: errors of %.1e at the advised step, %.1e at an eighth", order, error[0], error[3]);
    if (order >= 0.7 || error[0] < 1e-3) return 1;      /* a force that ends with a jump has errors of no order */
    EXAM_SAY("order %.1f: errors of %.1e at the advised step, %.1e at an eighth: does a force contain dt, or memory grow by "
             "slip instead of slip_step?", order, error[0], error[3]);
    return 0;
}
static inline double exam_seconds(const exam *e, int calls) {
    unsigned seed = 9;
    exam_path p;
    exam_go to[64];
    clock_t begun;
    int k;
    exam_begin(&p, e);
    for (k = 0; k < 64; k++) to[k] = exam_stray(e, k, &seed);
    begun = clock();
    for (k = 0; k < calls; k++) exam_move(&p, &to[k & 63], exam_dt(e));
    return (double)(clock() - begun)/CLOCKS_PER_SEC;
}
static inline void exam_plain(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    dem_law_hertz(c, memory + 3, f);
    dem_law_spring(c, memory, f);
}
static inline int exam_is_quick(const exam *e, char *found) {
    exam plain = *e;
    double own = 1e300, other = 1e300;
    int k;
    plain.law = exam_plain; plain.memory = 3; plain.vectors = 1;
    for (k = 0; k < 5; k++) {
        own = fmin(own, exam_seconds(e, 4000));
        other = fmin(other, exam_seconds(&plain, 4000));
    }
    EXAM_SAY("%.0f ns a contact, called by pointer; Hertz with a spring %.0f ns", own/4000*1e9, other/4000*1e9);
    if (own <= 10*other + 1e-5) return 1;
    EXAM_SAY("%.0f ns a contact, %.0f times Hertz with a spring: what is the same for all contacts belongs into c->user",
             own/4000*1e9, own/other);
    return 0;
}

/* The lines, in the order of their numbers. */
typedef struct exam_row { const char *asks; int (*answer)(const exam *e, char *found); } exam_row;
static inline const exam_row *exam_rows(void) {
    static const exam_row rows[EXAM_LINES] = {
        {"finite, whatever comes", exam_is_finite}, {"no hidden state", exam_is_pure},
        {"memory only in a step", exam_is_asked}, {"the same seen from a and from b", exam_is_swapped},
        {"the same in every frame", exam_is_turned}, {"rotates with the contact", exam_is_carried},
        {"springs grow by slip_step", exam_is_displaced}, {"friction has a limit", exam_is_bounded},
        {"no jumps, from beginning to end", exam_is_smooth},
        {"no energy from pressing", exam_is_pressed}, {"no energy from slipping", exam_is_sheared},
        {"no energy from rolling", exam_is_rolled}, {"no energy from pressing while sheared", exam_is_mixed},
        {"no energy from impacts", exam_is_bounced}, {"stable at the largest allowed step", exam_is_stable},
        {"converges with the step", exam_is_ordered}, {"quick", exam_is_quick}};
    return rows;
}
/* Checks all lines in order. DEM_ERROR_ARGUMENT if the law is null or its memory out of limits; the first line of the sheet
   then has the message. */
static inline dem_result exam_take(exam *e, exam_sheet *sheet) {
    const exam_row *row = exam_rows();
    int k;
    memset(sheet, 0, sizeof *sheet);
    sheet->name = e->name ? e->name : "a law";
    for (k = 0; k < EXAM_LINES; k++) sheet->line[k].asks = row[k].asks;
    if (!e->law || e->memory < 0 || e->memory > DEM_LAW_MEMORY || e->vectors < 0 || 3*e->vectors > e->memory || !exam_contact(e)) {
        snprintf(sheet->line[0].found, sizeof sheet->line[0].found, "exam_take: %s is examined with law %s, memory %d, "
                 "vectors %d: give a function, 0 to %d reals, no more vectors than they hold, a radius, material and speed "
                 "that a world takes, and to a law of bonds a range", sheet->name, e->law ? "given" : "null", e->memory,
                 e->vectors, (int)DEM_LAW_MEMORY);
        return DEM_ERROR_ARGUMENT;
    }
    for (k = 0; k < EXAM_LINES; k++) {
        if (e->tell) e->tell(k);
        sheet->line[k].passed = row[k].answer(e, sheet->line[k].found);
        sheet->passed += sheet->line[k].passed;
    }
    if (e->tell) e->tell(EXAM_LINES);
    return DEM_OK;
}
static inline void exam_print(const exam_sheet *sheet, FILE *out) {
    int k;
    for (k = 0; k < EXAM_LINES; k++)
        fprintf(out, "%-6s  %-38s  %s\n", sheet->line[k].passed ? "passed" : "FOUND", sheet->line[k].asks,
                sheet->line[k].found);
    fprintf(out, "%s: %d of %d lines passed\n", sheet->name, sheet->passed, (int)EXAM_LINES);
}
#endif
