/* 04_own_law.c - lesson 4: a contact law of your own, and the exam it has to pass.

   Question:  a spring that is stiffer on the way out than on the way in: k1 while loading, k2 while unloading. The area
              between the two lines is energy lost. If k2 = 4 k1, which restitution follows: 1/2, 1/4, or does it depend
              on the speed? And what is wrong with the law `hasty` below, which does what is said here? Write it down,
              then run.
   Theory:    Walton & Braun, J. Rheol. 30 (1986) 949: loading F = k1 d, unloading F = k2 (d - d0) from the largest
              overlap D; so d0 = (1 - k1/k2) D stays as a dent. The work that comes back is k1/k2 of what went in:
                  e = sqrt(k1/k2),  whatever the speed
   The law sees one contact, remembers one number, D, and answers with a force. The exam (exam.h, docs/laws.md) moves a
   law by hand and lets grains collide: is it finite, the same from both sides and in every frame, free of energy from
   nothing, stable at the step advised? Without a dent, stiffer on the way out gives more than was taken: the exam finds
   it.
   Build:     cc -O2 04_own_law.c ../dem.c -lm
   Run:       04_own_law, or 04_own_law --replay for a film of k2 = 4 k1, 04_own_law.html
   Expected:  e within .2 % for four ratios at two speeds; the exam passed; the hasty version fails it
   Exercises: check with 04_own_law --check N VALUE
   1  Which k2/k1 gives a restitution of .3?
   2  Of a law with e = .6, which share of the largest overlap stays as a dent? */
#include "../dem.h"
#include "exam.h"
#include "lesson.h"

static double answer(int exercise);

typedef struct springs { double k1, k2; } springs;                  /* N/m */

static void hysteretic(const dem_contact *c, dem_real *memory, dem_contact_force *force) {
    const springs *k = (const springs *)c->user;
    dem_real most = memory[0] > c->overlap ? memory[0] : c->overlap;    /* m */
    dem_real loading = k->k1*c->overlap;
    dem_real unloading = k->k2*(c->overlap - (1 - k->k1/k->k2)*most);
    force->normal = unloading < loading ? unloading : loading;
    if (force->normal < 0) force->normal = 0;                       /* inside the dent: nothing */
    if (c->dt > 0) memory[0] = most;                                /* dt = 0: only asked, not run */
}
/* A hasty version: "stiffer on the way out", word for word. */
static void hasty(const dem_contact *c, dem_real *memory, dem_contact_force *force) {
    const springs *k = (const springs *)c->user;
    (void)memory;
    force->normal = (c->closing_speed > 0 ? k->k1 : k->k2)*c->overlap;
}
static exam_sheet examine(const char *name, dem_law_fn law, springs *k) {
    exam_sheet sheet;
    exam e = exam_of(name, law, k, 1, 0, k->k2);            /* 1 real of memory, no vector, the stiffest spring */
    exam_take(&e, &sheet);
    exam_print(&sheet, stdout);
    return sheet;
}

/* Two equal grains meet head-on: speed after over speed before; < 0: the run broke. */
static double collide(springs *k, double speed, dem_replay_desc *film_desc) {
    const double radius = 0.005;                                    /* m */
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.law = hysteretic;
    desc.law_user = k;
    desc.law_memory = 1;
    desc.law_stiffness = k->k2;                                     /* what the time step must resolve */
    dem_world *world = dem_world_create(&desc);
    dem_material_desc clay_desc = DEM_MATERIAL_DESC;
    clay_desc.density = 2000;                                       /* kg/m3 */
    clay_desc.young = 1e7;                                          /* required, though our law looks away */
    clay_desc.restitution = 1;
    dem_material clay = dem_material_add(world, &clay_desc);
    dem_body pair[2];
    dem_body_state state;
    for (int i = 0; i < 2; i++) {
        pair[i] = dem_sphere_add(world, clay, radius, dem_vec3_make((2*i - 1)*1.01*radius, 0, 0));
        dem_body_get(world, pair[i], &state);
        state.velocity.x = (1 - 2*i)*speed/2;
        dem_body_set(world, pair[i], &state);
    }
    dem_world_check_print(world, stdout);
    dem_replay *film = film_desc ? dem_replay_open(world, "04_own_law.html", film_desc) : 0;
    const double bit = (0.1*radius/speed + 5e-3)/100;               /* s */
    for (int i = 0; i < 100; i++) {
        if (dem_world_run(world, bit, 0, 0) != DEM_OK) { puts(dem_world_error_get(world)); return -1; }
        dem_body_get(world, pair[1], &state);
        dem_replay_value_set(film, "force (N)", state.force.x);
        dem_replay_value_set(film, "speed (m/s)", state.velocity.x);
    }
    dem_replay_close(film);
    dem_world_destroy(world);
    return 2*state.velocity.x/speed;
}

int main(int argc, char **argv) {
    const int replay = lesson_begin(argc, argv, "04_own_law", answer);
    const double ratios[] = {1, 2, 4, 10}, speeds[] = {0.1, 1};     /* k2/k1, m/s */
    dem_replay_desc film_desc = DEM_REPLAY_DESC;
    film_desc.interval = 5.5e-5;                                    /* s */
    springs k = {1e4, 4e4};
    exam_sheet good = examine("hysteretic", hysteretic, &k), bad = examine("hasty", hasty, &k);
    lesson_row("lines of the exam passed, of 14", good.passed, 0, EXAM_LINES, 0);
    lesson_range("by the hasty version", bad.passed, 0, 1, EXAM_LINES - 2);
    for (int i = 0; i < 8; i++) {
        char name[64];
        k.k2 = ratios[i/2]*k.k1;
        snprintf(name, sizeof name, "restitution, k2 = %.0f k1, %.1f m/s", ratios[i/2], speeds[i%2]);
        lesson_row(name, collide(&k, speeds[i%2], replay && i == 5 ? &film_desc : 0), 0, sqrt(k.k1/k.k2), 0.2);
    }
    return lesson_end();
}

/* The marking. Stop here if you want to find the answers by yourself. */
static double answer(int exercise) { return exercise == 1 ? 1/(0.3*0.3) : 1 - 0.6*0.6; }
