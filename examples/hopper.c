/* hopper.c - a small project in one file: a hopper from an STL file, filled by a sieve curve and emptied through its
   mouth; discharge to a CSV file, a replay, checkpoints, and a restart after an interruption.

   Build:  cc -O2 -o hopper hopper.c ../dem.c -lm           (in the folder examples)
   Run:    cd data && ../hopper                             (the folder of hopper.stl)
           ../hopper --resume continues from the last checkpoint. hopper.csv then has each line exactly once */
#include "../dem.h"
#include <string.h>

static void discharge(const dem_world *world, double *values, void *outlet) {
    dem_outlet_state out;
    dem_outlet_get(world, *(dem_outlet *)outlet, &out);
    values[0] = out.total_mass;
    values[1] = (double)out.total;
}
int main(int argc, char **argv) {
    const int resume = argc > 1 && !strcmp(argv[1], "--resume");
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.gravity.z = -9.81;                                             /* m/s2 */
    dem_world *world = dem_world_create(&desc);
    dem_material_desc grit_desc = DEM_MATERIAL_DESC;
    grit_desc.density = 2600;                                           /* kg/m3 */
    grit_desc.young = 3e7;                                              /* Pa; softened */
    grit_desc.restitution = 0.4;
    grit_desc.friction = 0.5;
    dem_material grit = dem_material_add(world, &grit_desc);

    const char *parts[2] = {"bin", "gate"};
    dem_wall walls[2];
    for (int k = 0; k < 2; k++) {
        dem_mesh mesh;
        dem_mesh_part_read(world, "hopper.stl", parts[k], &mesh, 0);
        dem_mesh_place(world, &mesh, 1e-3, dem_quat_make(1, 0, 0, 0), dem_vec3_make(0, 0, 0)); /* mm to m */
        walls[k] = dem_wall_mesh_add(world, grit, &mesh);
        dem_mesh_free(world, &mesh);
    }
    dem_sizes curve = {DEM_SIZES_SIEVE_CURVE, 0, 0, 0, 0, 0, 0, 0, 3, {1e-3, 1.5e-3, 2e-3}, {0.2, 0.6, 1}, 0}; /* m, - */
    dem_region above = {{{-0.017, -0.017, 0.045}, {0.017, 0.017, 0.1}}, 'z', 0, 0};
    dem_sizes_fill(world, grit, &curve, above, 1200, 1);
    dem_outlet_desc mouth = DEM_OUTLET_DESC;
    mouth.box = dem_box_make(-1, -1, -1, 1, 1, 0.01);
    dem_outlet outlet = dem_outlet_add(world, &mouth);

    dem_output_desc lines = DEM_OUTPUT_DESC;
    lines.kind = DEM_OUTPUT_CSV; lines.path = "hopper.csv"; lines.interval = 0.02;
    lines.columns = "mass grains"; lines.values = discharge; lines.user = &outlet;
    dem_output_add(world, &lines);
    dem_output_every_add(world, DEM_OUTPUT_CHECKPOINT, "hopper.ckpt", 0.2);

    dem_result well = resume ? dem_checkpoint_read(world, "hopper.ckpt")
                             : dem_world_settle(world, 2, 0, dem_progress_print, stderr);
    if (well != DEM_OK) puts(dem_world_error_get(world));                   /* the message of this call, before another one fails */
    if (well == DEM_OK && !resume) dem_wall_remove(world, walls[1]);                      /* the gate opens */
    dem_replay_desc replay_desc = DEM_REPLAY_DESC;
    replay_desc.interval = 0.02;
    dem_replay *replay = dem_replay_open(world, resume ? "hopper2.html" : "hopper.html", &replay_desc);
    if (well == DEM_OK && (well = dem_world_run_to(world, 1.5, dem_progress_print, stderr)) != DEM_OK)
        puts(dem_world_error_get(world));
    dem_replay_close(replay);
    dem_world_report(world, stdout);
    dem_world_destroy(world);
    return well != DEM_OK;
}
