/* corona.h - grains in a corona electrostatic separator: field, charges, forces. MIT licence. Include it after dem.h.

   A rotor at 0 V rotates about z through the origin. An electrode at `voltage` is parallel to it. Ions from a corona hit a
   part of the rotor. Each grain carries three numbers (desc.body_reals = CORONA_REALS):

       induced   C, charge of conductors; flows to and from the rotor while they touch it
       corona    C, charge of insulators: ions that stick to them; leaks into rotor and brush
       landing   m, x at which the grain passed the plane y = bins on its way down; 0: not yet

   A body force adds electric forces and drag. Charges and body force depend on the grain alone, so threads and restarts do
   not matter. Forces between near grains need corona_near_update between two steps: it lists near pairs with their
   positions and velocities. The force is that at the positions of each step, of second order in the step.

       corona c = corona_make();
       c.field = corona_field_make(0.160, 0.019, 0.267, CORONA_PI/6, 30e3);
       c.kinds[copper.id].metal = 1; c.kinds[copper.id].density = 8400;
       desc.body_reals = CORONA_REALS; desc.body_reals_fn = corona_reals; desc.body_reals_user = &c;
       desc.body_force = corona_force; desc.force_user = &c;

   [LI08] Li, Lu, Xu & Zhou, J. Hazard. Mater. 151 (2008) 52; [CRI14] Critelli, Tasora, Degiorgi & Colledani, Particle
   simulation of granular flows in electrostatic separation processes (2014), whose equations are cited; [FEL66] Felici,
   Rev. Gen. Elec. 75 (1966) 1145; [PAU32] Pauthenier & Moreau-Hanot, J. Phys. Radium 3 (1932) 590; [PEE29] Peek,
   Dielectric Phenomena in High Voltage Engineering (1929); [SN33] Schiller & Naumann, Z. VDI 77 (1933) 318; [HS08] Hölzer &
   Sommerfeld, Powder Technol. 184 (2008) 361.
   Each function states how we differ from [CRI14]. Limits: the field is that of two infinite cylinders. It contains neither
   the charge of the grains nor that of the ions between the cylinders, which `strength` and the window represent. */
#ifndef CORONA_H
#define CORONA_H
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CORONA_PI 3.14159265358979323846
#define CORONA_EPS0 8.8541878128e-12         /* F/m; [CRI14] calls it permeability */
#define CORONA_REALS "induced corona landing"
enum { CORONA_INDUCED, CORONA_IONS, CORONA_LANDING, CORONA_REAL_COUNT };
enum { CORONA_KINDS = 65, CORONA_SHAPES = 33 };

/* ---- field ---- */

/* The field of two parallel cylinders in closed form: a pair of line charges at a distance c from the radical plane, on
   either side of it. */
typedef struct corona_field {
    double rotor, electrode, distance;       /* m: radii, between the axes */
    double angle, voltage;                   /* rad, of the electrode above +x; V */
    double h1, h2, c, scale, offset;         /* m, m, m, V, of the potential: 1 */
    double cosine, sine;
} corona_field;

/* [LI08]. The charges lie c from the radical plane, which is h1 from the rotor's axis and h2 from the electrode's. */
static inline corona_field corona_field_make(double rotor, double electrode, double distance, double angle,
                                             double voltage) {
    corona_field f;
    double d1, d2;
    f.rotor = rotor; f.electrode = electrode; f.distance = distance; f.angle = angle; f.voltage = voltage;
    f.h1 = (distance*distance + rotor*rotor - electrode*electrode)/(2*distance);
    f.h2 = distance - f.h1;
    f.c = sqrt(f.h1*f.h1 - rotor*rotor);
    d1 = (f.c - f.h1 + rotor)/(f.c + f.h1 - rotor);
    d2 = (f.c - f.h2 + electrode)/(f.c + f.h2 - electrode);
    f.offset = log(d1);
    f.scale = -voltage/log(d1*d2);
    f.cosine = cos(angle);
    f.sine = sin(angle);
    return f;
}
/* Returns the potential (V) at a point, which must be outside both cylinders. */
static inline double corona_potential(const corona_field *f, double x, double y) {
    const double X = x*f->cosine + y*f->sine - f->h1, Y = y*f->cosine - x*f->sine;
    const double a2 = (X + f->c)*(X + f->c) + Y*Y, b2 = (X - f->c)*(X - f->c) + Y*Y;
    return f->scale*(log(a2/b2)/2 - f->offset);
}
/* Returns the field (V/m), minus the gradient of the potential, rotated back into x and y (which the program of [CRI14]
   omits); 0 inside the rotor. */
static inline void corona_field_at(const corona_field *f, double x, double y, double E[2]) {
    const double X = x*f->cosine + y*f->sine - f->h1, Y = y*f->cosine - x*f->sine;
    const double a2 = (X + f->c)*(X + f->c) + Y*Y, b2 = (X - f->c)*(X - f->c) + Y*Y;
    const double along = -f->scale*((f->c + X)/a2 + (f->c - X)/b2), across = -f->scale*(Y/a2 - Y/b2);
    const int inside = x*x + y*y < f->rotor*f->rotor*(1 - 1e-9);
    E[0] = inside ? 0 : along*f->cosine - across*f->sine;
    E[1] = inside ? 0 : along*f->sine + across*f->cosine;
}
/* Returns the field (V/m) at the surface of a wire of this radius (m) at which the corona begins [PEE29]. air: its density
   over that at 1 atm and 25 C; roughness 0.6 to 0.9 (1: polished). */
static inline double corona_peek(double radius, double air, double roughness) {
    return 3.0e6*air*roughness*(1 + 0.030/sqrt(air*radius));
}
/* Returns the voltage (V) between a rotor and a wire (radii, distance of axes: m) at which the corona begins. */
static inline double corona_onset(double rotor, double wire, double distance, double air, double roughness) {
    const corona_field f = corona_field_make(rotor, wire, distance, 0, 1);
    double E[2];
    corona_field_at(&f, distance - wire, 0, E);
    return corona_peek(wire, air, roughness)/fabs(E[0]);
}

/* ---- charges; radius: m, of the sphere of equal volume; E: V/m ---- */

/* Returns the charge (C) of a conducting sphere that touches a plane electrode [FEL66], eq 11, with the epsilon_r of air, 1. */
static inline double corona_induced(double radius, double E) {
    return 2*CORONA_PI*CORONA_PI*CORONA_PI/3*CORONA_EPS0*radius*radius*E;
}
/* Returns the largest charge (C) that ions give to an insulating sphere [PAU32], eq 13. */
static inline double corona_saturation(double radius, double E, double permittivity) {
    return 12*CORONA_PI*CORONA_EPS0*radius*radius*E*permittivity/(permittivity + 2);
}
/* Returns the time (s) to half of that charge in a current of ions of `current` (A/m2). */
static inline double corona_time(double E, double current) { return 4*CORONA_EPS0*fabs(E)/current; }
/* Returns the charge (C) after dt (s) of ions. Qs t/(t + tau) of [PAU32] solves dQ/dt = Qs/tau (1 - Q/Qs)^2; this is its
   exact step from any charge. Above saturation no more ions arrive. tau 0: at once, as in [CRI14]. */
static inline double corona_charged(double charge, double saturation, double tau, double dt) {
    const double left = saturation > 0 || saturation < 0 ? 1 - charge/saturation : 0;
    if (!(left > 0)) return charge;
    return tau > 0 ? saturation*(1 - left/(1 + left*dt/tau)) : saturation;
}

/* ---- forces ---- */

/* Returns the attraction (N) to a conducting plane at this distance (m), eq 12 with d = r. */
static inline double corona_image(double charge, double distance) {
    return charge*charge/(16*CORONA_PI*CORONA_EPS0*distance*distance);
}
typedef enum corona_drag { CORONA_DRAG_NONE, CORONA_DRAG_STOKES, CORONA_DRAG_SCHILLER, CORONA_DRAG_HOLZER } corona_drag;
/* Returns drag over relative speed (N s/m) at this relative speed (m/s). [CRI14] uses Stokes's law. At 0.5 mm and 1 m/s Re is
   67, and the law of Schiller and Naumann (up to Re = 1000; above, a coefficient of 0.44) gives 3.7 times that. It is also what
   this function returns for CORONA_DRAG_HOLZER, which needs a shape: see corona_air. */
static inline double corona_drag_over_speed(corona_drag law, double radius, double speed, double density,
                                            double viscosity) {
    const double stokes = 6*CORONA_PI*viscosity*radius, re = 2*radius*speed*density/viscosity;
    if (law == CORONA_DRAG_NONE) return 0;
    if (law == CORONA_DRAG_STOKES || !(re > 0)) return stokes;
    return stokes*(re < 1000 ? 1 + 0.15*pow(re, 0.687) : 0.44*re/24);
}
/* The form of an ellipsoid, relative to the sphere of equal volume. */
typedef struct corona_outline {
    double axes[3];                          /* semi-axes over the sphere's radius */
    double sphericity;                       /* surface of the sphere over its surface */
} corona_outline;
/* Returns the outline of an ellipsoid with these semi-axes (any unit). Its surface is that of Thomsen's formula, within 1.1 %. */
static inline corona_outline corona_outline_make(const double *axes) {
    const double r = cbrt(axes[0]*axes[1]*axes[2]), p = 1.6075;
    corona_outline o;
    int k;
    for (k = 0; k < 3; k++) o.axes[k] = axes[k]/r;
    o.sphericity = pow((pow(o.axes[0]*o.axes[1], p) + pow(o.axes[0]*o.axes[2], p) + pow(o.axes[1]*o.axes[2], p))/3, -1/p);
    if (o.sphericity > 1 - 1e-12) o.sphericity = 1;          /* a sphere, despite round-off: the last term of [HS08] has an
                                                                infinite slope there */
    return o;
}
/* Returns the area of the outline seen along a unit vector in its axes, over that of the sphere. */
static inline double corona_outline_area(const corona_outline *o, const double *n) {
    const double *a = o->axes;
    const double x = n[0]*a[1]*a[2], y = n[1]*a[0]*a[2], z = n[2]*a[0]*a[1];
    return sqrt(x*x + y*y + z*z);
}
/* Returns the drag coefficient [HS08, eq 9] of an ellipsoid in a stream along the unit vector n in its axes. It refers to the
   cross section and the Reynolds number of the sphere of equal volume. With areas in units of that cross section, the
   lengthwise sphericity is 1/(half the surface - mean area seen from the sides); the mean is over four directions, 45 degrees
   apart. In the last term 0.42 and 10 are two factors; some programs read them as the one number 0.4210. */
static inline double corona_drag_coefficient(const corona_outline *o, const double *n, double re) {
    const int least = fabs(n[0]) < fabs(n[1]) ? fabs(n[0]) < fabs(n[2]) ? 0 : 2 : fabs(n[1]) < fabs(n[2]) ? 1 : 2;
    const double phi = o->sphericity, length = sqrt(1 - n[least]*n[least]);
    double u[3], v[3], m[3], side = 0, along;
    int i, k;
    for (k = 0; k < 3; k++) u[k] = ((k == least) - n[least]*n[k])/length;
    for (k = 0; k < 3; k++) v[k] = n[(k + 1)%3]*u[(k + 2)%3] - n[(k + 2)%3]*u[(k + 1)%3];
    for (i = 0; i < 4; i++) {
        for (k = 0; k < 3; k++) m[k] = cos(i*CORONA_PI/4)*u[k] + sin(i*CORONA_PI/4)*v[k];
        side += corona_outline_area(o, m)/4;
    }
    along = 1/(2/phi - side);
    return 8/(re*sqrt(along)) + 16/(re*sqrt(phi)) + 3/(sqrt(re)*pow(phi, 0.75)) +
        0.42*pow(10, 0.4*pow(-log10(phi), 0.2))*corona_outline_area(o, n);
}

/* ---- grains ---- */

typedef struct corona_kind {                 /* of each material */
    double metal;                            /* 0 to 1, fraction that conducts; between 0 and 1: the weighted
                                                average of [CRI14] */
    double permittivity;                     /* of the rest, relative */
    double density;                          /* kg/m3 */
} corona_kind;
/* The points at which a body that is not a sphere can touch: spheres (corners if their radius is 0) about the centre of
   mass, in the frame in which the shape was given; `radius` as in dem_shape_info. */
typedef struct corona_shape {
    int count;
    const dem_real *points, *radii;
    dem_real radius;
    dem_vec3 centre;
    dem_quat frame;                          /* of its principal axes, as in dem_shape_info */
    corona_outline outline;                  /* of the ellipsoid with its moments of inertia: the drag */
} corona_shape;
/* A window: angles (rad) clockwise from the top of the rotor, up to `depth` (m) above it. */
typedef struct corona_window { double begin, end, depth; } corona_window;

typedef struct corona {
    corona_field field;
    double speed;                            /* rad/s, of the rotor, clockwise; it carries air along (swirl) */
    corona_window ions, brush;
    double strength;                         /* V/m at the grain, with the ions' own field; 0: that of `field` */
    double current;                          /* A/m2 of ions; 0: they charge at once */
    double onset;                            /* V, no ions below */
    double contact_time, leak_time;          /* s: of conductors and insulators on the rotor; 0: at once; never */
    double brush_time;                       /* s: time constant of discharging and stopping in the brush; 0: no brush */
    double scatter;                          /* charge of each grain: 1 - scatter times 0 .. 1, by its id */
    double touch;                            /* m, largest gap that counts as contact with the rotor; impulses leave
                                                gaps of (v dt)^2/(2 R) on a rotor of radius R */
    double at_contact, in_flight;            /* share of Q E that acts on a conductor: on the rotor, eq 10: 0.832; off it: 1 */
    int in_front;                            /* 1: metal takes its charge in the window of the corona without touching, as in
                                                [CRI14] */
    double field_share;                      /* factor on the field of the electrode: 1 */
    double image_permittivity;               /* er of eq 12, which divides the image force: 1 */
    int image, pull;                         /* 1: image force; 1: force Q E on the charge of ions, not in [CRI14] */
    corona_drag drag;
    double air_density, air_viscosity;       /* kg/m3, Pa s */
    double wind[2], swirl;                   /* m/s; share of the rotor's surface speed, falls with 1/r */
    double bins;                             /* m, y of the plane */
    corona_kind kinds[CORONA_KINDS];         /* by id of material */
    corona_shape shapes[CORONA_SHAPES];      /* by id of shape; 0 is not used */
    /* near grains: Coulomb's force and that of their images, within `range` m; period along z, 0: none */
    double range, period;
    struct corona_place *order;              /* charged grains along x */
    int *at, *partner;                       /* by slot: 1 + its place in order, 0: none; in order, of all in turn */
    uint32_t near_count, order_count, partner_count;
    double near_time;                        /* s, at which the pairs were listed */
} corona;

/* A conductor and a plane, in air; nothing else is switched on. */
static inline corona corona_make(void) {
    corona c;
    memset(&c, 0, sizeof c);
    c.touch = 2e-6;
    c.at_contact = 0.832;
    c.in_flight = c.field_share = c.image_permittivity = 1;
    c.image = c.pull = 1;
    c.drag = CORONA_DRAG_SCHILLER;
    c.air_density = 1.204;
    c.air_viscosity = 1.81e-5;
    c.bins = -1e30;
    return c;
}

/* Returns a pseudorandom number of a grain, 0 <= number < 1. */
static inline double corona_chance(dem_body id) {
    uint64_t z = ((uint64_t)id.slot << 32 | id.generation) + UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ (z >> 30))*UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27))*UINT64_C(0x94D049BB133111EB);
    return (double)((z ^ (z >> 31)) >> 11)/9007199254740992.0;
}
/* Returns the gap (m) between the rotor and a grain; if the gap to its bounding sphere is larger than the radius of that
   sphere, this gap. The corners represent the faces. Between two corners at a distance l, a face is nearer to a rotor of
   radius R by l^2/(8 R); the value of the widest face is subtracted. */
static inline double corona_gap(const corona *c, const dem_body_state *body) {
    const double x = (double)body->position.x, y = (double)body->position.y;
    const double bound = sqrt(x*x + y*y) - c->field.rotor - (double)body->radius;
    const corona_shape *s = body->shape.id > 0 && body->shape.id < CORONA_SHAPES ? &c->shapes[body->shape.id] : 0;
    double least = 1e30, scale;
    int i;
    if (!s || !s->count || bound > (double)body->radius) return bound;
    scale = (double)(body->radius/s->radius);
    for (i = 0; i < s->count; i++) {
        const dem_vec3 p = dem_vec3_make(s->points[3*i] - s->centre.x, s->points[3*i + 1] - s->centre.y,
                                         s->points[3*i + 2] - s->centre.z);
        const dem_vec3 q = dem_quat_rotate(body->orientation, p);
        const double px = x + scale*(double)q.x, py = y + scale*(double)q.y;
        const double gap = sqrt(px*px + py*py) - c->field.rotor - (s->radii ? scale*(double)s->radii[i] : 0);
        if (gap < least) least = gap;
    }
    return s->radii ? least : least - (double)(body->radius*body->radius)/(2*c->field.rotor);
}
/* The quantities of a grain that forces and charges need. */
typedef struct corona_grain {
    const corona_kind *kind;
    double radius, height, angle;            /* m: of equal volume; of the centre above the rotor; rad from the top */
    double out[2], E[2];                     /* unit, from the axis; V/m */
    int touches;                             /* the rotor */
} corona_grain;
static inline corona_grain corona_grain_of(const corona *c, const dem_body_state *body) {
    const double x = (double)body->position.x, y = (double)body->position.y, away = sqrt(x*x + y*y);
    corona_grain g;
    g.kind = &c->kinds[body->material.id];
    g.radius = cbrt(3*(double)body->mass/(4*CORONA_PI*g.kind->density));
    g.height = away - c->field.rotor;
    g.angle = atan2(x, y);
    g.out[0] = x/away; g.out[1] = y/away;
    corona_field_at(&c->field, x, y, g.E);
    g.E[0] *= c->field_share; g.E[1] *= c->field_share;
    g.touches = g.height < 2*(double)body->radius && corona_gap(c, body) < c->touch;
    return g;
}
static inline int corona_inside(const corona_window *w, const corona_grain *g) {
    double angle = g->angle;
    while (angle < w->begin) angle += 2*CORONA_PI;
    return angle < w->end && g->height < w->depth;
}

typedef struct corona_place {
    double x[3], v[3], a[3], charge, radius; /* m, m/s, m/s2, C, m */
    uint32_t slot;
    int first, last;                         /* of its partners */
} corona_place;
/* Adds to `force` the Coulomb force (N) of a product of charges (C2) at this distance vector (m). Below the distance `least`
   the force does not grow. */
static inline void corona_coulomb(double product, const double *way, double least, double *force) {
    const double d2 = way[0]*way[0] + way[1]*way[1] + way[2]*way[2], d = sqrt(d2) > least ? sqrt(d2) : least;
    const double f = product/(4*CORONA_PI*CORONA_EPS0*d*d*d);
    int k;
    for (k = 0; k < 3; k++) force[k] += f*way[k];
}
/* Adds the forces (N) of the grain's partners and of their images. An image has the opposite charge and is as far behind the
   rotor's surface as its grain is in front of it; near the rotor the force therefore falls with 1/d^4. Partners are moved by
   their velocity and force since corona_near_update: after one step exactly to the positions of velocity Verlet. */
static inline void corona_near_force(const corona *c, const dem_body_state *body, dem_body id, double time, double *force) {
    const int me = id.slot <= c->near_count ? c->at[id.slot - 1] - 1 : -1;
    const double t = time - c->near_time, R2 = c->field.rotor*c->field.rotor;
    const double x[3] = {(double)body->position.x, (double)body->position.y, (double)body->position.z};
    int i, k;
    for (i = me < 0 ? 0 : c->order[me].first; me >= 0 && i < c->order[me].last; i++) {
        const corona_place *p = c->order + c->partner[i];
        const double charge = c->order[me].charge*p->charge, least = (p->radius + (double)body->radius)/2;
        double y[3], way[3], image[3], z;
        for (k = 0; k < 3; k++) y[k] = p->x[k] + t*(p->v[k] + t/2*p->a[k]);
        for (k = 0; k < 3; k++) way[k] = x[k] - y[k];
        if (c->period > 0) way[2] -= c->period*floor(way[2]/c->period + 0.5);
        corona_coulomb(charge, way, least, force);
        z = R2/(y[0]*y[0] + y[1]*y[1]);
        image[2] = way[2];
        for (k = 0; k < 2; k++) image[k] = x[k] - z*y[k];
        corona_coulomb(-charge, image, least, force);
    }
}
/* Returns drag over relative speed (N s/m) for air that streams past the grain with w (m/s). The law [HS08] takes an
   ellipsoid of the grain's volume, with the proportions of the one that has the grain's moments of inertia, in the present
   orientation. Its force is along w, without lift and torque. */
static inline double corona_air(const corona *c, const dem_body_state *body, double radius, const double *w) {
    static const corona_outline round = {{1, 1, 1}, 1};
    const double speed = sqrt(w[0]*w[0] + w[1]*w[1] + w[2]*w[2]), re = 2*radius*speed*c->air_density/c->air_viscosity;
    const corona_shape *s = body->shape.id > 0 && body->shape.id < CORONA_SHAPES ? &c->shapes[body->shape.id] : 0;
    const corona_outline *o = s && s->outline.sphericity > 0 ? &s->outline : &round;
    double n[3] = {1, 0, 0};
    if (c->drag != CORONA_DRAG_HOLZER) return corona_drag_over_speed(c->drag, radius, speed, c->air_density, c->air_viscosity);
    if (!(re > 1e-9)) return 6*CORONA_PI*c->air_viscosity*radius;
    if (o != &round) {
        const dem_vec3 m = dem_quat_unrotate(dem_quat_multiply(body->orientation, s->frame),
            dem_vec3_make((dem_real)(w[0]/speed), (dem_real)(w[1]/speed), (dem_real)(w[2]/speed)));
        n[0] = (double)m.x; n[1] = (double)m.y; n[2] = (double)m.z;
    }
    return corona_drag_coefficient(o, n, re)*c->air_density*CORONA_PI*radius*radius*speed/2;
}
/* Computes the force on one grain: a dem_body_force_fn; user is the corona.
   0.832 Q E lifts a conductor while it touches, and Q E attracts it in flight (eq 10 keeps the factor there). Its image and
   Q E hold the charge of ions on the rotor; [CRI14] omits this Q E, although it is as large as the image force. */
static inline void corona_force(const dem_body_state *body, dem_body id, double time, dem_vec3 *force, dem_vec3 *torque,
                                void *user) {
    const corona *c = (const corona *)user;
    const corona_grain g = corona_grain_of(c, body);
    const double induced = (double)body->reals[CORONA_INDUCED], ions = (double)body->reals[CORONA_IONS];
    const double charge = (g.touches ? c->at_contact : c->in_flight)*induced + (c->pull ? ions : 0);
    const double held = c->image ? corona_image(ions, g.height > g.radius ? g.height : g.radius)/c->image_permittivity : 0;
    const double away = g.height + c->field.rotor, air = c->swirl*c->speed*c->field.rotor*c->field.rotor/away;
    const double w[3] = {c->wind[0] + air*g.out[1] - (double)body->velocity.x,
                         c->wind[1] - air*g.out[0] - (double)body->velocity.y, -(double)body->velocity.z};
    const double drag = corona_air(c, body, g.radius, w);
    double F[3];
    (void)torque;
    F[0] = charge*g.E[0] - held*g.out[0] + drag*w[0];
    F[1] = charge*g.E[1] - held*g.out[1] + drag*w[1];
    F[2] = drag*w[2];
    if (c->brush_time > 0 && corona_inside(&c->brush, &g)) {    /* bristles stop the grains that they reach */
        const double stop = (double)body->mass/c->brush_time;
        F[0] -= stop*(double)body->velocity.x;
        F[1] -= stop*(double)body->velocity.y;
        F[2] -= stop*(double)body->velocity.z;
    }
    corona_near_force(c, body, id, time, F);
    *force = dem_vec3_make((dem_real)F[0], (dem_real)F[1], (dem_real)F[2]);
}

/* Returns a charge that relaxes to `to` with the time constant `time` (s). */
static inline double corona_relaxed(double charge, double to, double time, double dt) {
    return time > 0 ? to + (charge - to)*exp(-dt/time) : to;
}
/* Updates the charges of one grain over a step: a dem_reals_fn; user is the corona. [CRI14] charges plastic and metal as soon
   as they are in front of the rotor. Here metal is charged while it touches the rotor and keeps its charge in flight; plastic
   is charged in the window and loses charge while it touches. */
static inline void corona_reals(dem_real *reals, const dem_real *rates, const dem_body_state *body, dem_body id,
                                double time, dem_real dt, void *user) {
    const corona *c = (const corona *)user;
    const corona_grain g = corona_grain_of(c, body);
    const double share = 1 - c->scatter*corona_chance(id), step = (double)dt;
    const double below = c->bins - (double)body->position.y, down = -(double)body->velocity.y;
    double induced = (double)reals[CORONA_INDUCED], ions = (double)reals[CORONA_IONS];
    (void)rates; (void)time;
    if (g.touches || (c->in_front && corona_inside(&c->ions, &g))) {
        const double normal = g.E[0]*g.out[0] + g.E[1]*g.out[1];
        induced = corona_relaxed(induced, share*g.kind->metal*corona_induced(g.radius, normal), c->contact_time, step);
        if (g.touches && c->leak_time > 0) ions = corona_relaxed(ions, 0, c->leak_time, step);
    }
    if (g.kind->metal < 1 && fabs(c->field.voltage) >= c->onset && corona_inside(&c->ions, &g)) {
        const double E = c->strength > 0 ? c->strength : sqrt(g.E[0]*g.E[0] + g.E[1]*g.E[1]);
        const double sign = c->field.voltage < 0 ? -1 : 1;
        const double most = sign*share*(1 - g.kind->metal)*corona_saturation(g.radius, E, g.kind->permittivity);
        ions = corona_charged(ions, most, c->current > 0 ? corona_time(E, c->current) : 0, step);
    }
    if (c->brush_time > 0 && corona_inside(&c->brush, &g)) {
        induced = corona_relaxed(induced, 0, c->brush_time, step);
        ions = corona_relaxed(ions, 0, c->brush_time, step);
    }
    reals[CORONA_INDUCED] = (dem_real)induced;
    reals[CORONA_IONS] = (dem_real)ions;
    if (below >= 0 && down > 0 && !(reals[CORONA_LANDING] > 0 || reals[CORONA_LANDING] < 0)) {
        const double x = (double)body->position.x - (double)body->velocity.x*(below/down < step ? below/down : step);
        reals[CORONA_LANDING] = (dem_real)(x > 0 || x < 0 ? x : 1e-9);
    }
}

/* ---- near grains ---- */

static inline int corona_place_before(const void *a, const void *b) {
    const corona_place *p = (const corona_place *)a, *q = (const corona_place *)b;
    if (p->x[0] < q->x[0] || p->x[0] > q->x[0]) return p->x[0] < q->x[0] ? -1 : 1;
    return p->slot < q->slot ? -1 : p->slot > q->slot;
}
/* Enlarges *array, which has room for *room items, to `count` items. Returns 0 if memory runs out. */
static inline int corona_grow(void **array, uint32_t *room, uint32_t count, size_t size) {
    void *more = *array;
    if (count <= *room) return 1;
    more = realloc(more, 2*(size_t)count*size);
    if (!more) return 0;
    *array = more;
    *room = 2*count;
    return 1;
}
/* Lists the pairs of charged grains that are nearer than `range`, with positions and velocities. Call it from one thread
   before each step, or less often as long as grains hardly change their velocities. Returns 0 if memory runs out. corona_end
   frees the memory. */
static inline int corona_near_update(corona *c, const dem_world *world) {
    const dem_bodies b = dem_bodies_get(world);
    const dem_world_desc desc = dem_world_desc_get(world);
    uint32_t slots = 0, count = 0;
    void *at = c->at, *order = c->order, *partner = c->partner;
    int i, j, k, way, n = 0;
    if (!(c->range > 0) || !b.reals) return 1;
    for (i = 0; i < b.count; i++) if (b.slots[i] + 1 > slots) slots = b.slots[i] + 1;
    if (!corona_grow(&at, &c->near_count, slots, sizeof *c->at)) return 0;
    c->at = (int *)at;
    if (!corona_grow(&order, &c->order_count, (uint32_t)b.count, sizeof *c->order)) return 0;
    c->order = (corona_place *)order;
    if (c->near_count) memset(c->at, 0, c->near_count*sizeof *c->at);
    c->near_time = dem_world_time_get(world);
    for (i = 0; i < b.count; i++) {
        const dem_real *reals = b.reals + (size_t)b.real_count*(size_t)i;
        const double charge = (double)reals[CORONA_INDUCED] + (double)reals[CORONA_IONS], mass = (double)b.masses[i];
        corona_place *p = c->order + n;
        if (!(charge > 0 || charge < 0)) continue;
        p->a[0] = (double)desc.gravity.x; p->a[1] = (double)desc.gravity.y; p->a[2] = (double)desc.gravity.z;
        for (k = 0; k < 3; k++) {
            p->x[k] = (double)b.positions[4*i + k];
            p->v[k] = (double)b.velocities[4*i + k];
            p->a[k] += (double)b.forces[4*i + k]/mass;
        }
        p->radius = (double)b.positions[4*i + 3];
        p->charge = charge;
        p->slot = b.slots[i];
        n++;
    }
    if (n) qsort(c->order, (size_t)n, sizeof *c->order, corona_place_before);
    for (i = 0; i < n; i++) {
        c->order[i].first = (int)count;
        for (way = -1; way <= 1; way += 2)
            for (j = i + way; j >= 0 && j < n && fabs(c->order[j].x[0] - c->order[i].x[0]) < c->range; j += way) {
                const double x = c->order[i].x[0] - c->order[j].x[0], y = c->order[i].x[1] - c->order[j].x[1];
                double z = c->order[i].x[2] - c->order[j].x[2];
                if (c->period > 0) z -= c->period*floor(z/c->period + 0.5);
                if (!(x*x + y*y + z*z < c->range*c->range)) continue;
                if (!corona_grow(&partner, &c->partner_count, count + 1, sizeof *c->partner)) return 0;
                c->partner = (int *)partner;
                c->partner[count++] = j;
            }
        c->order[i].last = (int)count;
    }
    for (i = 0; i < n; i++) c->at[c->order[i].slot] = 1 + i;
    return 1;
}
static inline void corona_end(corona *c) {
    free(c->at);
    free(c->order);
    free(c->partner);
    c->at = c->partner = 0;
    c->order = 0;
    c->near_count = c->order_count = c->partner_count = 0;
}
#endif
