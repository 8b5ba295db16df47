/* two_files.c - a small program that only includes dem.h; make check links it with dem.c, or defines
   DEM_IMPLEMENTATION on the command line. Two unlike grains meet head-on in each of two worlds. */
#include "dem.h"

int main(void) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *worlds[2];
    double momentum, worst = 0;
    uint64_t hashes[2];
    int i;
    for (i = 0; i < 2; i++) {
        dem_material_desc glass_desc = DEM_MATERIAL_DESC;
        dem_material glass;
        dem_body left;
        dem_body_state state;
        worlds[i] = dem_world_create(&desc);
        if (!worlds[i]) { printf("%s\n", dem_world_create_error_get(&desc)); return 1; }
        glass_desc.density = 2500;
        glass_desc.young = DEM_R(1e8);
        glass_desc.poisson = DEM_R(0.25);
        glass_desc.restitution = DEM_R(0.5);
        glass_desc.friction = DEM_R(0.5);
        glass = dem_material_add(worlds[i], &glass_desc);
        left = dem_sphere_add(worlds[i], glass, DEM_R(0.01), dem_vec3_make(DEM_R(-0.011), 0, 0));
        dem_sphere_add(worlds[i], glass, DEM_R(0.02), dem_vec3_make(DEM_R(0.021), 0, 0));
        if (dem_body_get(worlds[i], left, &state) != DEM_OK) return 1;
        state.velocity.x = 1;
        if (dem_body_set(worlds[i], left, &state) != DEM_OK) return 1;
        momentum = (double)state.mass;
        if (dem_world_run(worlds[i], 0.02, 0, 0) != DEM_OK) { printf("%s\n", dem_world_error_get(worlds[i])); return 1; }
        worst += dem_totals_get(worlds[i]).momentum[0]/momentum - 1;
        dem_body_get(worlds[i], left, &state);
        if (!(state.velocity.x < DEM_R(-0.2))) { printf("did not bounce: %g m/s\n", (double)state.velocity.x); return 1; }
        hashes[i] = dem_world_hash_get(worlds[i]);
    }
    for (i = 0; i < 2; i++) dem_world_destroy(worlds[i]);
    if (hashes[0] != hashes[1]) { printf("two equal worlds differ\n"); return 1; }
    if (!(worst < 1e-5 && worst > -1e-5)) { printf("momentum is off by %g of itself\n", worst); return 1; }
    return 0;
}
