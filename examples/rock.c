/* rock.c - a rock that breaks.

   Grains are packed into a block in which one site in seven is empty. Neighbours are bonded: bonds stretch, shear, bend and
   twist, and break for good beyond their strength (examples/laws/bond.h has the source). A plate presses the block from above.
   Its force first grows in proportion, then cracks run and the force falls. The largest force over the cross-section is the
   strength of the rock.

   Question:  How strong is a rock whose bonds are twice as strong? And one in which every second bond is missing?
   Build:     cc -O2 -o rock rock.c ../dem.c -lm      (in the folder examples)
   Output:    bonds twice as strong give 1.7 to 2.1 times the strength, half of the bonds 0.5 to 0.7 times. Most bonds hold when
              the rock breaks, because cracks run through the empty sites. rock.vtp (grains) and bonds.vtp (lines; `length` is
              negative for broken bonds) are for ParaView. 10 s on one core
   Exercises: Pull instead of pressing. How many times weaker is the rock? (Real rocks: 10 to 20 times.) What changes with
              `beta`, and with the speed of the plate, which is 1/600 of the speed of sound here? */
#include "../dem.h"
#include "laws/bond.h"

static const double R = 1e-3, side = 12e-3, tall = 22e-3;          /* m */

/* Returns 0 for one site in seven: it stays empty. */
static int occupied(dem_vec3 centre, dem_real radius, void *user) {
    unsigned *seed = (unsigned *)user;
    (void)centre; (void)radius;
    *seed = *seed*1664525u + 1013904223u;
    return (*seed >> 16)%7 != 0;
}
/* Bonds one pair in every `every`. */
typedef struct glue { dem_world *world; int every, count; } glue;
static void glue_bond(const dem_contact_info *c, dem_real *memory, void *user) {
    glue *g = (glue *)user;
    if (g->count++%g->every == 0) bond_make(c, memory, g->world);
}

/* Returns the strength (Pa) of a block with bonds of `strength` (Pa) on one pair in every `every`; -1: the run failed. `bonds`
   receives the numbers of intact and of broken bonds when the force has fallen to half of its maximum. */
static double press(double strength, int every, int bonds[2], int pictures) {
    bond cement = {DEM_R(1e7), DEM_R(2.5), DEM_R(0.8e-3), 0, 0, DEM_R(0.1)};
    glue tube = {0, every, 0};
    unsigned seed = 1;
    double force = 0, largest = 0;
    int step = 0;
    dem_world_desc desc = DEM_WORLD_DESC;
    cement.tension = cement.shear = (dem_real)strength;
    desc.law = bond_law;
    desc.law_user = &cement;
    desc.law_memory = 8;
    desc.law_vectors = 2;
    desc.law_memory_names = "shear_x shear_y shear_z bend_x bend_y bend_z twist length";
    desc.law_who = 1;
    desc.law_range = (dem_real)(0.2*R);
    desc.law_stiffness = (dem_real)(4*1e7*3.14159*0.64e-6/(2*R));   /* 4 E A/l: bond.h */
    desc.normal_law = DEM_NORMAL_LINEAR;                            /* of grains without bonds */
    dem_world *world = tube.world = dem_world_create(&desc);

    dem_material_desc stone_desc = DEM_MATERIAL_DESC;
    stone_desc.density = 2500;
    stone_desc.young = 1e7;
    stone_desc.poisson = 0.25;
    stone_desc.stiffness = 1e4;                                     /* N/m */
    stone_desc.restitution = 0.3;
    stone_desc.friction = 0.5;
    dem_material stone = dem_material_add(world, &stone_desc);
    dem_wall_plane_add(world, stone, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
    dem_wall plate = dem_wall_plane_add(world, stone, dem_vec3_make(0, 0, (dem_real)tall), dem_vec3_make(0, 0, -1));
    dem_spheres_pack(world, stone, (dem_real)R, (dem_real)(0.01*R),
                     dem_region_inside_make(dem_box_make(0, 0, 0, (dem_real)side, (dem_real)side, (dem_real)tall),
                                            occupied, &seed), 0);
    if (dem_bonds_make(world, (dem_real)(0.1*R), glue_bond, &tube) < 0) { puts(dem_world_error_get(world)); return -1; }

    dem_motion down = DEM_MOTION;
    down.kind = DEM_MOTION_TRANSLATING;
    down.velocity.z = DEM_R(-0.1);                                  /* m/s */
    dem_wall_motion_set(world, plate, &down);
    for (step = 0; step < 600 && !(force < 0.5*largest && largest > 0.1); step++) {
        dem_wall_loads loads;
        if (dem_world_run(world, 5e-5, 0, 0) != DEM_OK) { puts(dem_world_error_get(world)); return -1; }
        dem_wall_loads_get(world, plate, &loads);
        force = (double)loads.force.z;                              /* N */
        if (force > largest) largest = force;
    }
    bonds[0] = bonds[1] = 0;
    dem_contacts_each(world, bond_count, bonds);
    if (pictures && (dem_vtp_write(world, "rock.vtp") != DEM_OK || dem_contacts_vtp_write(world, "bonds.vtp") != DEM_OK))
        puts(dem_world_error_get(world));
    printf("%d grains, %d steps of 50 us; ", dem_bodies_get(world).count, step);
    dem_world_destroy(world);
    return largest/(side*side);
}

int main(void) {
    static const struct { const char *what; double strength; int every; double least, most; } rows[] = {
        {"bonds of 100 kPa", 1e5, 1, 1, 1}, {"of 200 kPa", 2e5, 1, 1.7, 2.1}, {"every second of 100 kPa", 1e5, 2, 0.5, 0.7}};
    double first = 0;
    int k, bonds[2], wrong = 0;
    for (k = 0; k < 3; k++) {
        const double bears = press(rows[k].strength, rows[k].every, bonds, k == 0);
        if (!k) first = bears;
        printf("%-24s strength %6.1f kPa, %.2f of the first; %d bonds intact, %d broken\n", rows[k].what, bears/1e3,
               bears/first, bonds[0], bonds[1]);
        wrong += !(bears > 0) || bears/first < rows[k].least || bears/first > rows[k].most;
    }
    return wrong;
}
