/* codes.h - functions that scenes pass to dem.h. CODE compiles its text and keeps it, so that a printed program can
   contain it. `scaled` is 1 if the function has no length, mass or time of its own, `turned` 1 if it has no
   direction: other scenes are not scaled or rotated. */
#ifndef REL_CODES_H
#define REL_CODES_H
#include "../../dem.h"
#include <string.h>

#define CODE(name, ...) __VA_ARGS__ static const char rel_text_##name[] = #__VA_ARGS__;
CODE(law_plain, static void law_plain(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    dem_law_linear(c, memory, f);
})
CODE(law_spring, static void law_spring(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    dem_law_hertz(c, memory, f);
    dem_law_spring(c, memory, f);
})
CODE(drag, static dem_vec3 drag(dem_vec3 x, dem_vec3 v, dem_real radius, dem_real mass, double t, void *user) {
    const dem_real k = (dem_real)-20*mass;
    (void)x; (void)radius; (void)t; (void)user;
    return dem_vec3_make(k*v.x, k*v.y, k*v.z);
})
CODE(swirl, static void swirl(const dem_body_state *body, dem_body id, double t, dem_vec3 *force, dem_vec3 *torque,
                              void *user) {
    const dem_real k = (dem_real)2*body->mass;
    (void)id; (void)t; (void)user; (void)torque;
    force->x -= k*body->velocity.x;
    force->y -= k*body->velocity.y;
    force->z -= k*body->velocity.z;
})
CODE(grow, static dem_real grow(const dem_body_state *body, dem_body id, double t, void *user) {
    (void)id; (void)t; (void)user;
    return (dem_real)0.2*body->radius;
})
CODE(numbers, static void numbers(dem_real *reals, const dem_real *rates, const dem_body_state *body, dem_body id,
                                  double t, dem_real dt, void *user) {
    (void)rates; (void)body; (void)id; (void)t; (void)user;
    reals[0] += dt;
})
CODE(nod, static void nod(double t, dem_pose *pose, void *user) {
    (void)user;
    pose->position.z += (dem_real)(2e-4*(1 - cos(300*t)));
    pose->velocity.z = (dem_real)(2e-4*300*sin(300*t));
})

typedef struct rel_code { const char *name, *text; void (*function)(void); int scaled, turned; } rel_code;
#define R_(name, scaled, turned) {#name, rel_text_##name, (void (*)(void))name, scaled, turned}
static const rel_code rel_codes[] = {
    R_(law_plain, 1, 1), R_(law_spring, 1, 1), R_(drag, 0, 1), R_(swirl, 0, 1), R_(grow, 0, 1), R_(numbers, 0, 1),
    R_(nod, 0, 0)
};
enum { REL_CODES = (int)(sizeof rel_codes/sizeof *rel_codes) };
static const char *const rel_texts[] = {"heat charge", "one two"};
static int rel_code_of(const char *name) {
    int i;
    for (i = 0; i < REL_CODES && strcmp(rel_codes[i].name, name); i++) continue;
    return i;
}
#endif
