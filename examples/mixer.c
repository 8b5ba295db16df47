/* mixer.c - a vessel stirred by an impeller from an STL file: the mixing of two layers over time, torque and power.

   Build:  cc -O2 -o mixer mixer.c ../dem.c -lm             (in the folder examples)
   Run:    cd data && ../mixer                              (the folder of impeller.stl)
   Output: mixer.csv, the Lacey index over time: 0 for two layers, 1 for a random mixture; mixer.html, a replay.
           The power of the impeller is torque times speed. It agrees within 3 % with the power lost in contacts */
#include "../dem.h"
#include <math.h>

static double lost(const dem_ledger ledger) { return ledger.normal + ledger.slide + ledger.tangent; }   /* J */
int main(void) {
    const double R = 0.04, layer = 0.017, speed = 6, turn = 6.28318530717959/speed, start = 0.3;    /* m; rad/s; s */
    const dem_world_desc desc = {.gravity = {0, 0, -9.81}, .impact_speed = 0.5, .ledger = 1};       /* m/s2, m/s */
    const dem_material_desc stuff = {.density = 2500, .young = 5e6, .poisson = 0.3, .restitution = 0.5, .friction = 0.4};
    const dem_motion stirring = {.kind = DEM_MOTION_ROTATING, .axis = {0, 0, 1}, .speed = speed, .start = 0.2, .ramp = 0.1};
    const dem_replay_desc replay_desc = {.interval = 0.04};
    dem_world *world = dem_world_create(&desc);
    const dem_material red = dem_material_add(world, &stuff), blue = dem_material_add(world, &stuff);
    const dem_wall_part part = {"impeller", red, stirring};
    dem_wall impeller;
    dem_result result = dem_wall_parts_add(world, "impeller.stl", 1e-3, 1, &part, &impeller);       /* mm to m */
    dem_wall_plane_add(world, red, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
    dem_wall_cylinder_add(world, red, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1), R, 1);
    for (int k = 0; k < 2; k++) {
        const dem_region at = {.box = {{-R, -R, k*layer}, {R, R, (k + 1)*layer}}, .cylinder = 'z'};
        dem_spheres_pack(world, k ? blue : red, 3e-3, 0, at, 0);
    }
    const dem_output_desc lines = {.kind = DEM_OUTPUT_CSV, .path = "mixer.csv", .interval = 0.05,
        .mixing = {.box = {{-R, -R, 0}, {R, R, 2*layer}}, .cells = {5, 5, 2}, .material = red}};
    dem_output_add(world, &lines);
    dem_replay *replay = dem_replay_open(world, "mixer.html", &replay_desc);
    dem_mixing mixing[2]; dem_ledger ledger[2]; dem_wall_loads loads;
    for (int k = 0; k < 2; k++) {                                   /* until full speed; four turns */
        dem_wall_loads_reset(world, impeller);
        if (result == DEM_OK) result = dem_world_run(world, k ? 4*turn : start, dem_progress_print, stderr);
        dem_mixing_get(world, &lines.mixing, mixing + k), ledger[k] = dem_ledger_get(world), dem_wall_loads_get(world, impeller, &loads);
    }
    dem_replay_close(replay);
    if (result != DEM_OK) { puts(dem_world_error_get(world)); return 1; }
    const double power = -loads.torque_impulse/loads.time*speed, dissipated = (lost(ledger[1]) - lost(ledger[0]))/loads.time;
    printf("Lacey index: %.2f, after four turns %.2f\n", mixing[0].lacey, mixing[1].lacey);
    printf("torque: %.4f N m; power: %.4f W, dissipated in contacts %.4f W\n", power/speed, power, dissipated);
    dem_world_destroy(world);
    return !(fabs(power/dissipated - 1) < 0.03 && mixing[1].lacey > 0.7);
}
