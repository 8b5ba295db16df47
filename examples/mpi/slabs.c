/* A rotating drum whose grains are distributed to MPI processes, one slab each. The result is compared
   with the same drum in one world and with the same slabs in one process.

       mpicc -O2 -ffp-contract=off -I. examples/mpi/slabs.c -o slabs -lm       (or: make mpi)
       mpirun -n 3 ./slabs [steps]

   The transport consists of two functions (transport.h): exchange with both neighbours in the ring,
   and reduce. Every process builds the same world, creates its slab and steps it. dem_slabs_collect
   then writes the whole state into the world of each process. Expected: the same bits as the slabs in
   one process, and after 4000 steps grains within 1e-11 m of those in one world. Collisions multiply
   round-off, so later the distance grows. */
#include "dem.h"
#include "transport.h"
#include <stdlib.h>

enum { GRAINS = 1200 };

/* Grains of three radii in a drum about x, between end planes. */
static dem_world *drum(void) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc glass_desc = DEM_MATERIAL_DESC;
    dem_motion motion = DEM_MOTION;
    dem_world *world;
    dem_material glass;
    dem_wall shell;
    int k;
    desc.gravity.z = DEM_R(-9.81);
    desc.dt = DEM_R(2e-5);
    desc.threads = 1;
    world = dem_world_create(&desc);
    glass_desc.density = 2500;
    glass_desc.young = DEM_R(1e6);
    glass_desc.poisson = DEM_R(0.25);
    glass_desc.restitution = DEM_R(0.6);
    glass_desc.friction = DEM_R(0.4);
    glass = dem_material_add(world, &glass_desc);
    shell = dem_wall_cylinder_add(world, glass, dem_vec3_make(0, 0, 0), dem_vec3_make(1, 0, 0),
                             DEM_R(0.02), 1);
    motion.kind = DEM_MOTION_ROTATING;
    motion.axis.x = 1;
    motion.speed = 10;
    dem_wall_motion_set(world, shell, &motion);
    dem_wall_plane_add(world, glass, dem_vec3_make(0, 0, 0), dem_vec3_make(1, 0, 0));
    dem_wall_plane_add(world, glass, dem_vec3_make(DEM_R(0.12), 0, 0), dem_vec3_make(-1, 0, 0));
    for (k = 2; k >= 0; k--) {
        const dem_real half = DEM_R(0.0135);
        dem_spheres_fill(world, glass, (dem_real)(1e-3*(1 + 0.3*k)),
                         dem_region_make(dem_box_make(0, -half, -half, DEM_R(0.12), half, half)),
                         GRAINS/3, (uint64_t)k + 1);
    }
    return world;
}
/* Returns the hash with contact history, which counts only while there is a contact list. */
static uint64_t digest(dem_world *world) {
    dem_candidates_rebuild(world);
    return dem_world_hash_get(world);
}
/* Returns the largest distance (m) between the same grains of two worlds. *twos: 1 if each grain is
   exactly once in both. */
static double apart(const dem_world *a, const dem_world *b, int *twos) {
    const dem_bodies p = dem_bodies_get(a), q = dem_bodies_get(b);
    int at[GRAINS], i, k;
    double most = 0;
    *twos = p.count == q.count;
    for (i = 0; i < GRAINS; i++) at[i] = -1;
    for (i = 0; i < p.count; i++) at[p.slots[i]] = i;
    for (i = 0; i < q.count; i++) {
        const int j = at[q.slots[i]];
        if (j < 0) { *twos = 0; continue; }
        at[q.slots[i]] = -1;
        for (k = 0; k < 3; k++) {
            const double d = (double)(q.positions[4*i + k] - p.positions[4*j + k]);
            if (d > most || -d > most) most = d > 0 ? d : -d;
        }
    }
    return most;
}

int main(int argc, char **argv) {
    const int steps = argc > 1 ? atoi(argv[1]) : 4000;
    dem_world *world, *one, *same;
    dem_slabs_desc desc = DEM_SLABS_DESC;
    dem_slabs *slabs, *here;
    dem_slab slab;
    int rank, size, twos, good;
    double begun, seconds, distance;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);

    world = drum();
    desc.count = size;
    desc.first = rank;
    desc.local = 1;
    desc.transport.exchange_fn = mpi_exchange;
    desc.transport.reduce_fn = mpi_reduce;
    slabs = dem_slabs_create(world, &desc);
    if (!slabs) { puts(dem_world_error_get(world)); MPI_Abort(MPI_COMM_WORLD, 1); }
    begun = MPI_Wtime();
    if (dem_slabs_step(slabs, steps) != DEM_OK) {
        puts(dem_slabs_error_get(slabs));
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
    seconds = MPI_Wtime() - begun;
    dem_slab_get(slabs, rank, &slab);
    printf("slab %d: %d grains, %d ghosts, %.2f s of %.2f s at work, %.1f kB sent a step\n", rank,
           slab.grains, slab.ghosts, slab.seconds, seconds, 1e-3*(double)slab.bytes/steps);
    if (dem_slabs_collect(slabs, world) != DEM_OK) puts(dem_slabs_error_get(slabs));
    dem_slabs_destroy(slabs);

    one = drum();                               /* the same scene in one world, and in slabs of one process */
    same = drum();
    desc = DEM_SLABS_DESC;
    desc.count = size;
    here = dem_slabs_create(same, &desc);
    dem_world_step(one, steps);
    dem_slabs_step(here, steps);
    dem_slabs_collect(here, same);
    dem_slabs_destroy(here);
    distance = apart(one, world, &twos);
    good = twos && distance < 1e-11 && digest(same) == digest(world);
    mpi_reduce(&distance, 1, 0, 0);
    if (rank == 0) {
        printf("grains lost or doubled = %s\n", twos ? "none" : "SOME");
        printf("distance from one world = %.3g m\n", distance);
        printf("bits of the slabs in one process = %s\n", digest(same) == digest(world) ? "same"
               : "DIFFERENT");
    }
    dem_world_destroy(one);
    dem_world_destroy(same);
    dem_world_destroy(world);
    MPI_Finalize();
    return !good;
}
