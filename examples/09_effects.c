/* 09_effects.c - only what a scene calls for: effects switched on one by one, and what a step costs then.

   Question: friction doubles what is computed in a contact. Does it double the time of a step? What does a
   ledger of energy cost, what a force field of one's own? Guess, then run.

   A bed of beads on a floor, in a periodic box. Each row of the table asks for one thing more than the row
   above it. What is not asked for is not computed: there is nothing to switch off. Worlds take turns, and
   medians are told, since other programs use the machine too; expect a few percent of noise. At last the scene
   with everything says what each effect takes of a step, and what was asked for and never happened: there is a
   lid of steel that nothing touches, so that glass has not met steel.

   Build:     cc -O2 09_effects.c ../dem.c -lm
   Run:       09_effects [budget]                   (2 s of wall time for the shares at the end)
   Expected:  a price list, from 1 to about 2; then the effects: wall 2 was never touched, and materials 1 and 2 neither */
#include "../dem.h"
#include <stdlib.h>
#include <time.h>

enum { PLAIN, FRICTION, ROLLING, SIZES, LEDGER, FIELD, ROWS, TURNS = 9 };
static const char *names[ROWS] = {"smooth beads, all alike", "friction", "rolling friction", "two sizes", "ledger of energy",
                                  "force field of one's own"};

/* Stokes' drag of air. */
static dem_vec3 air(dem_vec3 position, dem_vec3 velocity, dem_real radius, dem_real mass, double time, void *user) {
    (void)position; (void)mass; (void)time; (void)user;
    dem_real drag = (dem_real)(-6*3.1416*1.8e-5)*radius;            /* N s/m */
    return dem_vec3_make(drag*velocity.x, drag*velocity.y, drag*velocity.z);
}

/* A bed that asks for the first so many things of the list. */
static dem_world *bed(int things) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.gravity.z = -9.81;                                         /* m/s2 */
    desc.boundary[0] = desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
    desc.domain = dem_box_make(0, 0, 0, 0.015, 0.015, 0.05);           /* m */
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
    dem_plane_add(world, glass, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
    dem_box box = dem_box_make(0, 0, 0, 0.015, 0.015, 0.05);
    dem_spheres_fill(world, glass, things >= SIZES ? 0.8e-3 : 1e-3, box, 400, 1);
    dem_spheres_fill(world, glass, 1e-3, box, 400, 2);
    if (dem_world_run(world, 0.1, 0, 0) != DEM_OK) puts(dem_world_error(world));
    return world;
}
static double seconds_of(dem_world *world, int steps) {
    clock_t begun = clock();
    if (dem_world_step(world, steps) != DEM_OK) puts(dem_world_error(world));
    return (double)(clock() - begun)/CLOCKS_PER_SEC;
}
static int lower_first(const void *a, const void *b) {
    return (*(const double *)a > *(const double *)b) - (*(const double *)a < *(const double *)b);
}

int main(int argc, char **argv) {
    dem_world *world[ROWS];
    double time[ROWS][TURNS], before = 0;
    for (int row = 0; row < ROWS; row++) world[row] = bed(row);
    for (int turn = 0; turn < TURNS; turn++)
        for (int row = 0; row < ROWS; row++) time[row][turn] = seconds_of(world[row], 100);

    printf("%-28s%12s%16s%20s\n", "", "us per step", "without it = 1", "contacts per bead");
    for (int row = 0; row < ROWS; row++) {
        qsort(time[row], TURNS, sizeof **time, lower_first);
        double step = time[row][TURNS/2]/100;
        printf("%s %-26s%12.1f%16.2f%20.2f\n", row ? "+" : " ", names[row], 1e6*step, before > 0 ? step/before : 1,
               dem_counters_get(world[row]).contacts/800.0);
        before = step;
    }

    dem_world *all = world[ROWS - 1];                               /* two things that will not happen */
    dem_material_desc steel_desc = DEM_MATERIAL_DESC;
    steel_desc.density = 7850;
    steel_desc.young = 2e7;
    steel_desc.poisson = 0.3;
    steel_desc.restitution = 0.8;
    steel_desc.rolling_friction = 0.01;
    dem_material steel = dem_material_add(all, &steel_desc);
    dem_wall lid = dem_plane_add(all, steel, dem_vec3_make(0, 0, 0.07), dem_vec3_make(0, 0, -1));
    if (dem_world_step(all, 100) != DEM_OK) puts(dem_world_error(all));
    dem_effects_print(all, argc > 1 ? atof(argv[1]) : 2, stdout);

    dem_effect effects[DEM_EFFECTS];
    int missing = 0;
    for (int k = 0; k < dem_effects_get(all, 0, effects); k++) missing += effects[k].missing > 0;
    dem_wall_loads loads;
    int touched = dem_wall_loads_get(all, lid, &loads) != DEM_OK || loads.touched;
    for (int row = 0; row < ROWS; row++) dem_world_destroy(world[row]);
    return touched || !missing;
}
