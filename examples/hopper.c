/* hopper.c - a small project in one file: a hopper from an STL file, filled by a sieve curve and emptied through its
   mouth; discharge to a CSV file, a replay, checkpoints, and a restart after an interruption.

   Build:  cc -O2 -o hopper hopper.c ../dem.c -lm           (in the folder examples)
   Run:    cd data && ../hopper                             (the folder of hopper.stl)
           ../hopper --resume continues from the last checkpoint. hopper.csv then has each line exactly once.
   Output: the mean discharge until the hopper is empty, beside Beverloo's formula 0.58 rho sqrt(g) (D - 1.4 d)^2.5. D is the
           diameter of the mouth, d that of the grains, and rho the bulk density at a solid fraction of 0.6. The formula
           holds for a flat bottom. For a cone of half angle a, Rose and Tanaka (The Engineer 208, 465, 1959; quoted from
           memory) multiply it by (tan a tan b)^-0.35, where b is the angle of the stagnant zone, 45 degrees here. The
           program fails if the two differ by more than 20 % */
#include "../dem.h"
#include <math.h>
#include <string.h>

int main(int argc, char **argv) {
    const int resume = argc > 1 && !strcmp(argv[1], "--resume");
    const dem_world_desc desc = {.gravity = {0, 0, -9.81}};                                 /* m/s2 */
    const dem_material_desc stuff = {.density = 2600, .young = 3e7, .restitution = 0.4, .friction = 0.5};   /* kg/m3, Pa: softened */
    const dem_sizes curve = {.kind = DEM_SIZES_SIEVE_CURVE, .count = 3, .radius = {1e-3, 1.5e-3, 2e-3}, .passing = {0.2, 0.6, 1}};
    const dem_region above = {.box = {{-0.017, -0.017, 0.045}, {0.017, 0.017, 0.1}}, .cylinder = 'z'};      /* m */
    const dem_outlet_desc mouth = {.box = {{-1, -1, -1}, {1, 1, 0.028}}};
    const dem_replay_desc replay_desc = {.interval = 0.02};                                 /* s */
    dem_world *world = dem_world_create(&desc);
    const dem_material grit = dem_material_add(world, &stuff);
    const dem_wall_part parts[2] = {{.name = "bin", .material = grit}, {.name = "gate", .material = grit}};
    dem_wall walls[2]; dem_outlet_state out;
    dem_result result = dem_wall_parts_add(world, "hopper.stl", 1e-3, 2, parts, walls);     /* mm to m */
    dem_sizes_fill(world, grit, &curve, above, 1200, 1);
    if (result == DEM_OK && !resume) result = dem_world_settle(world, 2, 0, dem_progress_print, stderr);
    const dem_outlet outlet = dem_outlet_add(world, &mouth);
    const dem_output_desc lines = {.kind = DEM_OUTPUT_CSV, .path = "hopper.csv", .interval = 0.02, .outlet = outlet};
    dem_output_add(world, &lines);
    dem_output_every_add(world, DEM_OUTPUT_CHECKPOINT, "hopper.ckpt", 0.2);
    if (result == DEM_OK) result = resume ? dem_checkpoint_read(world, "hopper.ckpt") : dem_wall_remove(world, walls[1]);
    dem_replay *replay = dem_replay_open(world, resume ? "hopper2.html" : "hopper.html", &replay_desc);
    if (result == DEM_OK) result = dem_world_run_to(world, 1, dem_progress_print, stderr);
    if (result != DEM_OK) puts(dem_world_error_get(world));
    dem_replay_close(replay);
    dem_outlet_get(world, outlet, &out);                            /* D = 17.6 mm, d = 2.8 mm on average, tan a = 16/30 */
    const double flow = out.total_mass/(out.last - out.since), formula = 0.58*0.6*2600*sqrt(9.81)*pow(0.01368, 2.5)*pow(16/30.0, -0.35);
    printf("mean discharge %.4f kg/s, by the formula %.4f kg/s\n", flow, formula);
    dem_world_report(world, stdout);
    dem_world_destroy(world);
    return result != DEM_OK || !(fabs(flow/formula - 1) < 0.2);
}
