/* lab.c - the law lab: the exam, the curves and five small scenes for a contact law that lab.html translates from C to
   JavaScript, compiled to WebAssembly. As an ordinary program it prints the curves of a law that a C compiler has compiled.

   Build:  make web, and open build/web/lab.html; or  cc -O2 -DLAW_FILE='"my_law.h"' lab.c ../../dem.c -lm -o lab
   Run:    lab         prints "curve K", then x and y of its points, for all curves; then the scenes after some steps

   The law sees a copy of its contact, its memory and its force, in one piece of memory (`zone`): the page stops a law that
   writes elsewhere, and this file one that writes beyond the memory that its row LAW gives it. */
#define main lesson_main
#include "lesson.c"
#undef main
#include "../exam.h"
#include "../exam_curves.h"
#include "lab_row.h"

enum { GRAINS_TWO = 3, SHEAR, STACK = 8192, DATA = 2048, GUARD = 8 };
static struct {
    double stack[STACK], data[DATA];                /* of the translated law: its local and its static data */
    dem_contact contact;
    dem_real memory[DEM_LAW_MEMORY + GUARD], reals[4][DEM_BODY_REALS];
    dem_contact_force force;
} zone;
static struct { exam e; lab_row row; int beyond; exam_curve curve, other; char found[300]; double energy, amount, since; } lab;

#ifdef __wasm__
__attribute__((import_module("lab"), import_name("law")))
void lab_call(const dem_contact *c, dem_real *memory, dem_contact_force *f);
__attribute__((import_module("lab"), import_name("made")))
void lab_make(const dem_contact_info *c, dem_real *memory, void *user);
#else
#ifdef LAW_FILE
#include LAW_FILE
#else
static void spring(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    (void)memory;
    f->normal = 1e4*c->overlap;
}
#define LAW {"spring", spring, 0, 0, 0, 1e4, DEM_NORMAL_HERTZ, -1, 0, 0, 0}
#endif
static const lab_row row = LAW;
static void lab_call(const dem_contact *c, dem_real *memory, dem_contact_force *f) { row.law(c, memory, f); }
static void lab_make(const dem_contact_info *c, dem_real *memory, void *user) { row.made(c, memory, user); }
#endif

/* The law as dem.h calls it. */
static void lab_law(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const size_t held = (size_t)lab.row.memory*sizeof *memory, many = sizeof zone.reals[0];
    const dem_contact_who *who = &c->who;
    zone.contact = *c;
    zone.force = *f;
    memset(zone.memory, 0, sizeof zone.memory);
    if (held) memcpy(zone.memory, memory, held);
    if (who->rate_a) {
        memcpy(zone.reals[0], who->reals_a, many); memcpy(zone.reals[1], who->reals_b, many);
        memcpy(zone.reals[2], who->rate_a, many);  memcpy(zone.reals[3], who->rate_b, many);
        zone.contact.who.reals_a = zone.reals[0]; zone.contact.who.reals_b = zone.reals[1];
        zone.contact.who.rate_a = zone.reals[2];  zone.contact.who.rate_b = zone.reals[3];
    }
    lab_call(&zone.contact, zone.memory, &zone.force);
    if (who->rate_a) { memcpy(who->rate_a, zone.reals[2], many); memcpy(who->rate_b, zone.reals[3], many); }
    if (held) memcpy(memory, zone.memory, held);
    *f = zone.force;
    for (int k = lab.row.memory; k < DEM_LAW_MEMORY + GUARD; k++)
        if (!(zone.memory[k] <= 0 && zone.memory[k] >= 0)) lab.beyond = k + 1;
}

/* The function of a law that makes a bond. */
static void lab_bond(const dem_contact_info *c, dem_real *memory, void *user) {
    const size_t held = (size_t)lab.row.memory*sizeof *memory;
    memset(zone.memory, 0, sizeof zone.memory);
    lab_make(c, zone.memory, user);
    if (held) memcpy(memory, zone.memory, held);
}

/* Addresses of the zone: 0 begin, 1 static data, 2 the end of both, 3 the end of the zone. */
LESSON_API(lab_zone) void *lab_zone(int which) {
    return which == 0 ? (void *)zone.stack : which == 1 ? (void *)zone.data : which == 2 ? (void *)&zone.contact : (void *)(&zone + 1);
}
/* Returns k + 1 if the law has changed memory[k] beyond what its row gives it, otherwise 0. */
LESSON_API(lab_beyond) int lab_beyond(void) { return lab.beyond; }

/* What laws may call: the built-in laws, and what a bond needs. */
#define LAB_LAW(NAME) LESSON_API(lab_##NAME) void lab_##NAME(const dem_contact *c, dem_real *memory, dem_contact_force *f) { \
    NAME(c, memory, f); }
LAB_LAW(dem_law_hertz) LAB_LAW(dem_law_linear) LAB_LAW(dem_law_hysteretic) LAB_LAW(dem_law_viscous) LAB_LAW(dem_law_step)
LAB_LAW(dem_law_spring) LAB_LAW(dem_law_mindlin) LAB_LAW(dem_law_mindlin_rescaled) LAB_LAW(dem_law_roll_step)
LAB_LAW(dem_law_roll_constant) LAB_LAW(dem_law_roll_epsd) LAB_LAW(dem_law_twist)
LESSON_API(lab_dem_body_get) dem_result lab_dem_body_get(const dem_world *world, dem_body body, dem_body_state *state) {
    return dem_body_get(world, body, state);
}

/* Begins with a law. Returns 0, or another number if its row has values that no world takes: lab_found has the message. */
LESSON_API(lab_open) int lab_open(const lab_row *law) {
    exam_sheet sheet;
    lab.row = *law;
    lab.beyond = 0;
    lab.e = exam_of(law->name, lab_law, law->user, law->memory, law->vectors, law->stiffness);
    lab.e.coefficients = (dem_normal_law)law->coefficients;
    lab.e.range = law->range;
    lab.e.who = law->who;
    lab.e.made = law->made ? lab_bond : 0;
    if (law->memory < 0 || law->memory > DEM_LAW_MEMORY) lab.row.memory = 0;
    if (law->memory >= 0 && law->memory <= DEM_LAW_MEMORY && law->vectors >= 0 && 3*law->vectors <= law->memory && exam_contact(&lab.e))
        return 0;
    memset(&sheet, 0, sizeof sheet);
    lab.e.law = 0;
    exam_take(&lab.e, &sheet);
    memcpy(lab.found, sheet.line[0].found, sizeof sheet.line[0].found);
    return 1;
}
/* The lines of the exam, without the last one: the time of a law is that of its translation here. */
LESSON_API(lab_lines) int lab_lines(void) { return EXAM_COST; }
/* What line k of the exam asks; whether the law passes it; then what was found. */
LESSON_API(lab_asks) const char *lab_asks(int k) { return exam_rows()[k].asks; }
LESSON_API(lab_line) int lab_line(int k) {
    lab.found[0] = 0;
    return exam_rows()[k].answer(&lab.e, lab.found);
}
LESSON_API(lab_found) const char *lab_found(void) { return lab.found; }

/* Computes a curve: 0 and 1 force against overlap, quasi-static and at impact speed; 2 to 4 force against slip; 5 to 7 moment
   against angle; 8 restitution against speed; 9 and 10 energy and slip against the angle of an impact. Returns its length. */
enum { CURVES = 11 };
LESSON_API(lab_curve) int lab_curve(int kind) {
    static const double slips[3] = {0.1, 0.4, 2}, angles[3] = {0.002, 0.01, 0.05};
    exam_curve *c = &lab.curve;
    const exam *e = &lab.e;
    c->count = 0;
    if (kind < 2) exam_press(e, kind ? e->speed : 1e-5*e->speed, c);
    else if (kind < 5) exam_cycle(e, e->deep*e->radius*slips[kind - 2], 0, c);
    else if (kind < 8) exam_cycle(e, angles[kind - 5], 1, c);
    else if (e->made) return 0;                                          /* bonded grains do not bounce */
    else if (kind == 8) exam_bounces(e, c);
    else exam_slants(e, kind == 9 ? c : &lab.other, kind == 9 ? &lab.other : c);
    return c->count;
}
LESSON_API(lab_x) const double *lab_x(void) { return lab.curve.x; }
LESSON_API(lab_y) const double *lab_y(void) { return lab.curve.y; }

/* ---- scenes: those of the lesson with grains of 1 mm, two grains, and a sheared cell ---- */
static void with_law(dem_world_desc *desc, dem_material_desc *grains) {
    desc->impact_speed = (dem_real)lab.e.speed;
    desc->law = lab_law;
    desc->law_user = lab.e.user;
    desc->law_memory = lab.e.memory;
    desc->law_vectors = lab.e.vectors;
    desc->law_stiffness = (dem_real)lab.e.stiffness;
    desc->law_range = (dem_real)lab.e.range;
    desc->law_who = lab.e.who;
    desc->body_reals = lab.e.who ? "n1 n2 n3 n4 n5 n6 n7 n8" : 0;
    desc->normal_law = lab.e.coefficients;
    *grains = lab.e.material;
}
/* Begins a scene. own: of the lesson's scenes as there; of two grains the angle of the impact, degrees; of the cell the
   inertial number, shear rate times diameter over (pressure/density)^(1/2). Returns 0 on success. */
LESSON_API(lab_scene) int lab_scene(int scene, int grains, double friction, double own) {
    const dem_real pressure = 50;                                        /* Pa */
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_advice advice;
    lab.beyond = 0;
    lab.amount = lab.since = 0;
    lab.e.material.friction = friction;
    r = (dem_real)lab.e.radius; broad = 70*r; change = with_law;
    if (scene < GRAINS_TWO) return lesson_begin(scene, grains, friction, lab.e.material.restitution, own, 1.2);
    dem_world_destroy(now.world);
    free(now.start);
    free(now.grains);
    memset(&now, 0, sizeof now);
    now.scene = scene;
    now.R = broad*sqrt(grains/2000.0);
    desc.planar = 1;
    desc.thickness = 2*r;
    with_law(&desc, &now.gravel);
    if (scene == SHEAR) {
        const dem_real half = r*sqrt(grains*pi/0.7)/2;                   /* a solid fraction of 0.7 */
        desc.domain = dem_box_make(-half, -half, 0, half, half, 0);
        desc.boundary[0] = desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
        now.R = half;
    }
    now.world = dem_world_create(&desc);
    now.material = dem_material_add(now.world, &now.gravel);
    if (scene == GRAINS_TWO) {
        const double angle = own*pi/180, apart = 3*r;
        const dem_real v = (dem_real)lab.e.speed/2;
        for (int side = -1; side < 2; side += 2) {
            const dem_vec3 at = dem_vec3_make(side*(r*cos(angle) + apart/2), side*r*sin(angle), 0);
            const dem_body body = dem_sphere_add(now.world, now.material, r, at);
            dem_body_state state;
            if (dem_body_get(now.world, body, &state) != DEM_OK) return 1;
            state.velocity = dem_vec3_make(-side*v, 0, 0);
            if (dem_body_set(now.world, body, &state) != DEM_OK) return 1;
        }
    } else {
        const dem_region all = dem_region_make(desc.domain);
        dem_spheres_fill(now.world, now.material, r*0.85, all, grains/2, 1);
        dem_spheres_fill(now.world, now.material, r*1.15, all, grains - grains/2, 2);
    }
    now.start = calloc((size_t)grains + 3, sizeof *now.start);
    now.grains = calloc((size_t)grains + 3, NUMBERS*sizeof *now.grains);
    if (!now.start || !now.grains || dem_step_advice_get(now.world, &advice) != DEM_OK) return 1;
    if (dem_world_dt_set(now.world, 0.8*advice.dt_max) != DEM_OK) return 1;
    if (scene == GRAINS_TWO) lab.energy = dem_totals_get(now.world).kinetic;
    if (scene == SHEAR) {
        dem_cell_desc cell = DEM_CELL_DESC;
        cell.shear = own*sqrt(pressure/lab.e.material.density)/(2*r);
        cell.stress.y = pressure;
        cell.rate_most.y = 2*cell.shear;
        if (dem_cell_set(now.world, &cell) != DEM_OK) return 1;
    }
    return 0;
}
/* As lesson_measure; of two grains the kinetic energy over that at first; of the cell mu, shear stress over pressure. */
LESSON_API(lab_measure) double lab_measure(void) {
    if (now.scene == GRAINS_TWO) {
        const dem_totals sum = dem_totals_get(now.world);
        return (sum.kinetic + sum.rotational)/lab.energy;
    }
    if (now.scene == SHEAR) {
        dem_stress s;
        if (dem_stress_get(now.world, &s) != DEM_OK || !(s.total[1] > 0)) return 0;
        return -s.total[3]/s.total[1];
    }
    return lesson_measure();
}
/* Mean since the last call: the power of the drum on the grains, W, or the grains per second that leave the hopper. */
LESSON_API(lab_rate) double lab_rate(void) {
    const double amount = lab.amount, since = lab.since;
    dem_wall_loads loads;
    if (now.scene == HOPPER) lab.amount = lesson_measure();
    else if (now.scene == DRUM && dem_wall_loads_get(now.world, now.moving, &loads) == DEM_OK) lab.amount = loads.work;
    lab.since = lesson_time();
    return lab.since > since ? (lab.amount - amount)/(lab.since - since) : 0;
}
/* Half the size of what is to be seen, m. */
LESSON_API(lab_size) double lab_size(void) { return now.R; }

#ifndef __wasm__
int main(void) {
    static const double own[5] = {40, 8, 0.07, 30, 0.1};
    static const int steps[5] = {6000, 300, 300, 2000, 300};
    if (lab_open(&row)) { fprintf(stderr, "%s\n", lab_found()); return 1; }
    for (int k = 0; k < CURVES; k++) {
        const int count = lab_curve(k);
        printf("curve %d %d\n", k, count);
        for (int i = 0; i < count; i++) printf("%.17g %.17g\n", lab_x()[i], lab_y()[i]);
    }
    for (int k = 0; k < lab_lines(); k++) {
        const int passed = lab_line(k);
        printf("line %d %d %s\n", k, passed, lab_found());
    }
    for (int k = 0; k < 5; k++) {
        if (lab_scene(k, 200, 0.5, own[k]) || lesson_step(steps[k])) { printf("scene %d: %s\n", k, lesson_error()); continue; }
        printf("scene %d %.0f %.17g %016llx %.17g\n", k, lesson_steps(), lab_measure(), (unsigned long long)lesson_hash(), lab_rate());
    }
    return 0;
}
#endif
