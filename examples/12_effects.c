/* 12_effects.c - lesson 12: the cost of a step. You learn: only the effects of your scene cost time.

   Build:     cc -O2 -o 12_effects 12_effects.c ../dem.c -lm      (in the folder examples)
   Run:       ./12_effects or, with a replay of the bed with all effects, ./12_effects --replay
   Question:  Friction doubles the calculations in a contact. Does it double the time of a step? What does an energy
              ledger cost, and what a user-defined force field? Guess, then run.
   Method:    Six beds of beads in a periodic box, each with one effect more than the one before, take steps in turn;
              the table has medians, because other programs use the machine too. Then a steel lid is added to the last
              bed. No bead touches it, and dem_effects_print lists it among what has not happened. */
#include "../dem.h"
#include "lesson.h"
#include <time.h>

enum { PLAIN, FRICTION, ROLLING, SIZES, LEDGER, FIELD, ROWS, TURNS = 9, BEADS = 400 };
static const char *names[ROWS] = {"smooth beads, all alike", "friction", "rolling friction", "two sizes",
                                  "ledger of energy", "user-defined force field"};

/* Returns the drag of air on a bead by Stokes's law, N. */
static dem_vec3 air(dem_vec3 position, dem_vec3 velocity, dem_real radius, dem_real mass, double time, void *user) {
    (void)position, (void)mass, (void)time, (void)user;
    dem_real drag = (dem_real)(-6*3.1416*1.8e-5)*radius;            /* N s/m */
    return dem_vec3_make(drag*velocity.x, drag*velocity.y, drag*velocity.z);
}
/* Returns a bed after 0.28 s, with the first `things` effects of the list. */
static dem_world *bed(int things, int record) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.gravity.z = -9.81;                                         /* m/s2 */
    desc.boundary[0] = desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
    desc.domain = dem_box_make(0, 0, 0, 0.011, 0.011, 0.05);           /* m */
    desc.threads = 1;
    desc.ledger = things >= LEDGER;
    if (things >= FIELD) desc.force = air;
    dem_world *world = dem_world_create(&desc);

    dem_material_desc glass_desc = DEM_MATERIAL_DESC;
    glass_desc.density = 2500;                                      /* kg/m3 */
    glass_desc.young = 5e6;                                         /* Pa */
    glass_desc.poisson = 0.25;
    glass_desc.restitution = 0.5;
    glass_desc.friction = things >= FRICTION ? 0.4 : 0;
    glass_desc.rolling_friction = things >= ROLLING ? 0.05 : 0;
    dem_material glass = dem_material_add(world, &glass_desc);
    dem_wall_plane_add(world, glass, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
    dem_spheres_fill(world, glass, things >= SIZES ? 0.8e-3 : 1e-3, dem_region_make(desc.domain),
                     BEADS/2, 1);
    dem_spheres_fill(world, glass, 1e-3, dem_region_make(desc.domain), BEADS/2, 2);
    dem_replay_desc replay_desc = DEM_REPLAY_DESC;
    replay_desc.interval = 0.002;                                   /* s */
    dem_replay *replay = record ? dem_replay_open(world, "12_effects.html", &replay_desc) : 0;
    for (int i = 0; i < 140; i++) {
        if (dem_world_run(world, 0.002, 0, 0) != DEM_OK) puts(dem_world_error_get(world));
        dem_replay_value_set(replay, "contacts per bead", dem_counters_get(world).contacts/(double)BEADS);
    }
    dem_replay_close(replay);
    return world;
}
static double seconds_of(dem_world *world, int steps) {
    clock_t begun = clock();
    if (dem_world_step(world, steps) != DEM_OK) puts(dem_world_error_get(world));
    return (double)(clock() - begun)/CLOCKS_PER_SEC;
}
static int lower_first(const void *a, const void *b) {
    return (*(const double *)a > *(const double *)b) - (*(const double *)a < *(const double *)b);
}

int main(int argc, char **argv) {
    const int record = lesson_begin(argc, argv, "12_effects");
    dem_world *world[ROWS];
    double time[ROWS][TURNS], contacts[ROWS], step[ROWS];
    for (int row = 0; row < ROWS; row++) world[row] = bed(row, record && row == ROWS - 1);
    for (int turn = 0; turn < TURNS; turn++)
        for (int row = 0; row < ROWS; row++) time[row][turn] = seconds_of(world[row], 100);

    printf("%-28s%12s%16s%20s\n", "", "us per step", "factor", "contacts per bead");
    for (int row = 0; row < ROWS; row++) {
        qsort(time[row], TURNS, sizeof **time, lower_first);
        step[row] = time[row][TURNS/2]/100;
        contacts[row] = dem_counters_get(world[row]).contacts/(double)BEADS;
        printf("%s %-26s%12.1f%16.2f%20.2f\n", row ? "+" : " ", names[row], 1e6*step[row],
               row ? step[row]/step[row - 1] : 1, contacts[row]);
    }

    dem_world *all = world[ROWS - 1];                               /* a lid of steel that no bead touches */
    dem_material_desc steel_desc = DEM_MATERIAL_DESC;
    steel_desc.density = 7850;
    steel_desc.young = 2e7;
    steel_desc.restitution = 0.8;
    dem_material steel = dem_material_add(all, &steel_desc);
    dem_wall lid = dem_wall_plane_add(all, steel, dem_vec3_make(0, 0, 0.07), dem_vec3_make(0, 0, -1));
    if (dem_world_step(all, 100) != DEM_OK) puts(dem_world_error_get(all));
    dem_effects_print(all, 2, stdout);                              /* 2 s of wall time to measure costs */
    dem_effect effects[DEM_EFFECTS];
    int missing = 0;
    for (int k = 0; k < dem_effects_get(all, 0, effects); k++) missing += effects[k].missing > 0;
    dem_wall_loads loads;
    int touched = dem_wall_loads_get(all, lid, &loads) != DEM_OK || loads.touched;
    lesson_range("step with all five effects, over without", step[ROWS - 1]/step[PLAIN], 0, 1, 8);
    lesson_range("contacts per bead, smooth", contacts[PLAIN], 0, 2.5, 3.1);
    lesson_range("contacts per bead, with friction", contacts[FRICTION], 0, 1.8, 2.6);
    lesson_claim("nothing has touched the lid, and an effect reports it", !touched && missing > 0);
    for (int row = 0; row < ROWS; row++) dem_world_destroy(world[row]);
    return lesson_end();
}

/* STOP: answer the question before you read on.
   Theory:    dem.h computes only what a scene contains. Each effect multiplies the time of a step by a factor. A smooth
              contact has one unknown, its normal force; a bead at rest gives three equations, its balance of forces: 3
              contacts per bead. With friction a contact has three unknowns, a bead six equations: 2 are enough.
   Output:    the cost of each effect. All five together make a step 1 to 8 times as long. Contacts over beads, each
              counted once: 2.5 to 3.1 smooth (some are open while the bed vibrates), 1.8 to 2.6 with friction */
/* Exercises for ./12_effects --check N VALUE. {2: 1 to 3 by 0.1} is 2 or, for --seed NAME, in that range. */
const char *const exercises[2] = {
    "Friction makes a step {1.84: 1.2 to 2.4 by 0.02} times as long, rolling friction another {1.34: 1.1 to 1.6 "
    "by 0.02} times, the ledger another {1.12: 1.04 to 1.5 by 0.02} times. What is the factor of all three?",
    "What is the terminal speed, in m/s, of a glass bead (2500 kg/m3, R = {20: 8 to 28 by 1} um) in the field `air`?"};
/* Marking. Stop here if you want to find the answers yourself. Drag equals weight: 6 pi eta R v = m g. */
double answer(int exercise, const double *x) {
    return exercise == 1 ? x[0]*x[1]*x[2] : 2*2500*9.81*1e-12*x[0]*x[0]/(9*1.8e-5);
}
