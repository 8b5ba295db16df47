/* codes.h - functions that scenes pass to dem.h. CODE compiles its text and keeps it, so that a printed program can
   contain it. `scaled` is 1 if the function has no length, mass or time of its own, `turned` 1 if it has no
   direction: other scenes are not scaled or rotated. The shipped laws are in headers, which a program includes. DATA is
   what is passed to functions as `user`. */
#ifndef REL_CODES_H
#define REL_CODES_H
#include "../../dem.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "../../examples/laws/bond.h"
#include "../../examples/laws/capillary.h"
#include "../../examples/laws/charge.h"
#include "../../examples/laws/dmt.h"
#include "../../examples/laws/heat.h"
#include "../../examples/laws/jkr.h"
#include "../../examples/laws/luding.h"
#include "../../examples/laws/viscoelastic.h"
#include "../../examples/laws/walton_braun.h"

/* The units of length and time, for constants: relations change them. */
static double unit_m = 1, unit_s = 1;
#define CODE(name, ...) __VA_ARGS__ static const char rel_text_##name[] = #__VA_ARGS__;
CODE(law_plain, static void law_plain(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    dem_law_linear(c, memory, f);
})
CODE(law_spring, static void law_spring(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    dem_law_hertz(c, memory, f);
    dem_law_spring(c, memory, f);
})
CODE(drag, static dem_vec3 drag(dem_vec3 x, dem_vec3 v, dem_real radius, dem_real mass, double t, void *user) {
    const dem_real k = (dem_real)(-20/unit_s)*mass;
    (void)x; (void)radius; (void)t; (void)user;
    return dem_vec3_make(k*v.x, k*v.y, k*v.z);
})
CODE(swirl, static void swirl(const dem_body_state *body, dem_body id, double t, dem_vec3 *force, dem_vec3 *torque,
                              void *user) {
    const dem_real k = (dem_real)(2/unit_s)*body->mass;
    (void)id; (void)t; (void)user; (void)torque;
    force->x -= k*body->velocity.x;
    force->y -= k*body->velocity.y;
    force->z -= k*body->velocity.z;
})
CODE(settle, static void settle(const dem_body_state *body, dem_body id, double t, dem_vec3 *force, dem_vec3 *torque,
                                void *user) {
    const dem_real k = (dem_real)(t < 0.1 ? 200 : t < 0.12 ? 1000 : 0);
    (void)id; (void)user;
    force->x -= k*body->mass*body->velocity.x;
    force->y -= k*body->mass*body->velocity.y;
    force->z -= k*body->mass*body->velocity.z;
    torque->x -= k*body->inertia*body->spin.x;
    torque->y -= k*body->inertia*body->spin.y;
    torque->z -= k*body->inertia*body->spin.z;
})
CODE(no_force, static dem_vec3 no_force(dem_vec3 x, dem_vec3 v, dem_real radius, dem_real mass, double t, void *user) {
    (void)x; (void)v; (void)radius; (void)mass; (void)t; (void)user;
    return dem_vec3_make(0, 0, 0);
})
CODE(no_couple, static void no_couple(const dem_body_state *body, dem_body id, double t, dem_vec3 *force,
    dem_vec3 *torque,
                                      void *user) {
    (void)body; (void)id; (void)t; (void)force; (void)torque; (void)user;
})
CODE(no_growth, static dem_real no_growth(const dem_body_state *body, dem_body id, double t, void *user) {
    (void)body; (void)id; (void)t; (void)user;
    return 0;
})
CODE(grow, static dem_real grow(const dem_body_state *body, dem_body id, double t, void *user) {
    (void)id; (void)t; (void)user;
    return (dem_real)(0.2/unit_s)*body->radius;
})
CODE(numbers, static void numbers(dem_real *reals, const dem_real *rates, const dem_body_state *body, dem_body id,
                                  double t, dem_real dt, void *user) {
    (void)rates; (void)body; (void)id; (void)t; (void)user;
    reals[0] += dt;
})
CODE(nod, static void nod(double t, dem_pose *pose, void *user) {
    (void)user;
    pose->position.z += (dem_real)(2e-4*unit_m*(1 - cos(300/unit_s*t)));
    pose->velocity.z = (dem_real)(2e-4*unit_m*(300/unit_s)*sin(300/unit_s*t));
})

#include "codes_services.h"
CODE(law_inline, DEM_INLINE void law_inline(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    dem_law_linear(c, memory, f);
    dem_law_spring(c, memory, f);
})
CODE(law_in_rows, DEM_LAW_ROWS(law_in_rows, law_inline, 3))
CODE(law_far, static void law_far(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const dem_real *k = (const dem_real *)c->user;
    const dem_real gap = c->overlap < 0 ? c->range + c->overlap : c->range;
    if (c->overlap > 0) { dem_law_hertz(c, memory, f); dem_law_spring(c, memory, f); }
    else if (c->dt > 0) memory[0] = memory[1] = memory[2] = 0;
    f->normal -= k[0]*gap;
    f->energy.elastic -= k[0]*gap*(gap/2 + (c->overlap > 0 ? c->overlap : 0));
})
CODE(law_warm, static void law_warm(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const dem_real k = (dem_real)50, flow = k*(c->who.reals_b[0] - c->who.reals_a[0] + 1);
    dem_law_hertz(c, memory, f);
    dem_law_spring(c, memory, f);
    c->who.rate_a[0] += flow;
    c->who.rate_b[0] -= flow;
})
CODE(warm_rate, static void warm_rate(const dem_contact *c, dem_real *rates) {
    (void)c;
    rates[0] = (dem_real)50;
})
CODE(inside_half, static int inside_half(dem_vec3 centre, dem_real radius, void *user) {
    (void)radius;
    return centre.x >= (user ? *(const dem_real *)user : 0);
})
CODE(drag_of, static dem_vec3 drag_of(dem_vec3 x, dem_vec3 v, dem_real radius, dem_real mass, double t, void *user) {
    const dem_real k = -*(const dem_real *)user*mass;
    (void)x; (void)radius; (void)t;
    return dem_vec3_make(k*v.x, k*v.y, k*v.z);
})
CODE(grow_of, static dem_real grow_of(const dem_body_state *body, dem_body id, double t, void *user) {
    (void)id; (void)t;
    return *(const dem_real *)user*body->radius;
})
CODE(numbers_of, static void numbers_of(dem_real *reals, const dem_real *rates, const dem_body_state *body, dem_body id,
                                        double t, dem_real dt, void *user) {
    (void)body; (void)id; (void)t;
    reals[0] += dt*((rates ? rates[0] : 0) + *(const dem_real *)user);
})
CODE(nod_of, static void nod_of(double t, dem_pose *pose, void *user) {
    const dem_real a = *(const dem_real *)user;
    pose->position.y += (dem_real)((double)a*(1 - cos(400*t)));
    pose->velocity.y = (dem_real)((double)a*400*sin(400*t));
})
#define DATA(name, ...) static __VA_ARGS__ static const char rel_text_##name[] = "static " #__VA_ARGS__;
DATA(far_pull, dem_real far_pull[1] = {(dem_real)0.5};)
DATA(some_rate, dem_real some_rate[1] = {(dem_real)0.3};)
DATA(nod_by, dem_real nod_by[1] = {(dem_real)1e-4};)
DATA(bond_own, bond bond_own = {(dem_real)1e6, (dem_real)2.5, (dem_real)3e-4, (dem_real)1e4, (dem_real)1e4,
    (dem_real)0.1};)
DATA(capillary_own, capillary capillary_own = {(dem_real)0.073, (dem_real)0.3, (dem_real)4e-12};)
DATA(charge_own, const dem_real charge_work[] = {(dem_real)4.5, (dem_real)4.8};
     static charge charge_own = {charge_work, (dem_real)1e-7, 1};)
DATA(dmt_own, dmt dmt_own = {(dem_real)0.05};)
DATA(heat_own, const dem_real heat_of[] = {(dem_real)1, (dem_real)2};
     static heat heat_own = {heat_of, heat_of, 0, 0};)
DATA(jkr_own, jkr jkr_own = {(dem_real)0.05};)
DATA(luding_own, luding luding_own = {(dem_real)1e4, (dem_real)5e4, (dem_real)5e3, (dem_real)4e-5, 0};)
DATA(viscoelastic_own, viscoelastic viscoelastic_own = {(dem_real)4e-6};)
DATA(walton_braun_own, walton_braun walton_braun_own = {(dem_real)1e4, 1, (dem_real)3e4, 0};)

typedef struct rel_code { const char *name, *text; void (*function)(void); int scaled, turned; } rel_code;
#define R_(name, scaled, turned) {#name, rel_text_##name, (void (*)(void))name, scaled, turned}
#define H_(header, name) {#name, "#include \"examples/laws/" #header ".h\"", (void (*)(void))name, 0, 1}
static const rel_code rel_codes[] = {
    R_(law_plain, 1, 1), R_(law_spring, 1, 1), R_(drag, 1, 1), R_(swirl, 1, 1), R_(grow, 1, 1), R_(numbers, 1, 1),
    R_(nod, 1, 0), R_(settle, 0, 1), R_(no_force, 1, 1), R_(no_couple, 1, 1), R_(no_growth, 1, 1), REL_SERVICE_CODES,
    R_(law_inline, 1, 1), R_(law_in_rows, 1, 1), R_(law_far, 0, 1), R_(law_warm, 0, 1), 
    R_(warm_rate, 0, 1),
    R_(inside_half, 0, 0), R_(drag_of, 0, 1), R_(grow_of, 0, 1), R_(numbers_of, 0, 1), R_(nod_of, 0, 0),
    H_(bond, bond_law), H_(capillary, capillary_law), H_(charge, charge_law), H_(dmt, dmt_law), H_(heat, heat_law),
    H_(heat, heat_rate), H_(jkr, jkr_law), H_(luding, luding_law), H_(viscoelastic, viscoelastic_law),
    H_(walton_braun, walton_braun_law)
};
enum { REL_CODES = (int)(sizeof rel_codes/sizeof *rel_codes) };
static const char *const rel_texts[] = {
    "heat charge", "one two", "coarse fine", "coarse", "x y z", "grains_####.vtp", "grains.xyz",
        "contacts_####.vtp", "surfaces_####.vtp",
    "walls_####.vtp", "state_####.dem", "steps.csv", "loads.csv", "counts.csv", "mixing.csv", "values.csv",
        "bodies_####.csv",
    "contacts_####.csv", "field_####.csv", "every_####.vtp", "replay.html"
};
typedef struct rel_datum { const char *name, *text; void *at; } rel_datum;
#define D_(name) {#name, rel_text_##name, &name}
static const rel_datum rel_data[] = {
    D_(far_pull), D_(some_rate), D_(nod_by), D_(bond_own), D_(capillary_own), D_(charge_own), D_(dmt_own), D_(heat_own),
    D_(jkr_own), D_(luding_own), D_(viscoelastic_own), D_(walton_braun_own)
};
enum { REL_DATA_COUNT = (int)(sizeof rel_data/sizeof *rel_data),
    REL_TEXTS = (int)(sizeof rel_texts/sizeof *rel_texts) };
static int rel_datum_of(const char *name) {
    int i;
    for (i = 0; i < REL_DATA_COUNT && strcmp(rel_data[i].name, name); i++) continue;
    return i;
}
static int rel_text_of(const char *text) {
    int i;
    for (i = 0; i < REL_TEXTS && strcmp(rel_texts[i], text); i++) continue;
    return i;
}
static int rel_code_of(const char *name) {
    int i;
    for (i = 0; i < REL_CODES && strcmp(rel_codes[i].name, name); i++) continue;
    return i;
}
#endif
