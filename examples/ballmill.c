/* ballmill.c - a ball mill with lifters: its power by torque, by the ledger and by the sum of all contacts, the rates of
   collisions and the wear of the shell. The spectrum of impact energies goes to ballmill.csv: rates and power over energy.
   Build: cc -O2 -I. -o ballmill examples/ballmill.c dem.c -lm      Run: ./ballmill [share of critical speed] [turns] */
#include "dem.h"
#include <math.h>
#include <stdlib.h>

enum { PITCH = 7, LIFTERS = 12, CORNERS = PITCH*LIFTERS };

int main(int argc, char **argv) {
    const double pi = 3.14159265358979, R = 0.1, r = 4e-3, height = 6e-3, width = 0.05, g = 9.81, room = R - 1.5*height;
    const double share = argc > 1 ? atof(argv[1]) : 0.7, turns = argc > 2 ? atof(argv[2]) : 2;
    const double omega = share*sqrt(g/(R - r)), turn = 2*pi/omega;
    static const double along[PITCH] = {0, 0, 0.15, 0.15, 0.35, 0.57, 0.78};       /* corners of a lifter and of its arc */
    dem_real at[2*CORNERS]; int32_t ends[2*CORNERS];
    const dem_profile shell = {CORNERS, CORNERS, at, ends};
    const dem_world_desc desc = {.gravity = {0, -g, 0}, .ledger = 1, .tangent_law = DEM_TANGENT_MINDLIN_RESCALED,
        .domain = {{-1, -1, 0}, {1, 1, width}}, .boundary = {DEM_BOUNDARY_OPEN, DEM_BOUNDARY_OPEN, DEM_BOUNDARY_PERIODIC}};
    const dem_material_desc stuff = {.density = 7800, .young = 1e8, .poisson = 0.3, .restitution = 0.6, .friction = 0.4};
    const dem_motion motion = {.kind = DEM_MOTION_ROTATING, .axis = {0, 0, 1}, .speed = omega, .ramp = 0.2};
    const dem_region in = {.box = {{-room, -room, 0}, {room, room, width}}, .cylinder = 'z'};
    dem_world *world = dem_world_create(&desc);
    const dem_material steel = dem_material_add(world, &stuff), any = {0};
    for (int i = 0; i < CORNERS; i++) {
        const double a = 2*pi*(i/PITCH + along[i%PITCH])/LIFTERS, d = i%PITCH == 1 || i%PITCH == 2 ? R - height : R;
        at[2*i] = d*cos(a), at[2*i + 1] = d*sin(a), ends[2*i] = i, ends[2*i + 1] = (i + 1)%CORNERS;
    }
    const dem_wall drum = dem_wall_profile_add(world, steel, &shell, DEM_EDGE_RESOLVED);
    dem_wall_motion_set(world, drum, &motion);
    dem_spheres_fill(world, steel, r, in, 1000, 1);
    dem_result result = dem_world_run(world, 1.5*turn, dem_progress_print, stderr);
    const dem_ledger a = dem_ledger_get(world);
    dem_wall_loads_reset(world, drum);
    if (result == DEM_OK) result = dem_events_record(world, &DEM_EVENTS_DESC);
    if (result == DEM_OK) result = dem_world_run(world, turns*turn, dem_progress_print, stderr);
    const dem_ledger b = dem_ledger_get(world);
    dem_wall_loads loads; dem_impacts s; dem_wear wear;
    dem_wall_loads_get(world, drum, &loads);
    if (result != DEM_OK || dem_impacts_get(world, any, any, &s) != DEM_OK || dem_impacts_csv_write(world, "ballmill.csv") != DEM_OK ||
        dem_wall_wear_get(world, drum, 1e-4, 2e9, &wear) != DEM_OK) { puts(dem_world_error_get(world)); return 1; }
    printf("power: torque %.4f W, ledger %.4f W, contacts %.4f W\n", -loads.torque_impulse*omega/s.seconds,
           (b.normal + b.slide + b.tangent - a.normal - a.slide - a.tangent)/s.seconds,
           (s.lost_normal + s.lost_slide + s.lost_tangent)/s.seconds);
    printf("contacts: %.0f per second end, %d exist; wear of the shell %.3g mm3 per hour\n", s.rate, s.open, wear.volume/s.seconds*3.6e12);
    dem_world_destroy(world);
    return 0;
}
