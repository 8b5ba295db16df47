/* fuzz_grains.c - any bytes into dem_grains_parse: it must refuse or read them, and never crash or leak.
   `make fuzz`; seeds are in tests/corpus/grains. */
#define DEM_IMPLEMENTATION
#include "../dem.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc m = DEM_MATERIAL_DESC;
    dem_material stuff;
    dem_world *world;
    dem_grains grains;
    int i;
    desc.threads = 1;
    world = dem_world_create(&desc);
    if (!world) return 0;
    m.density = 2500;
    m.young = DEM_R(1e6);
    m.restitution = DEM_R(0.5);
    stuff = dem_material_add(world, &m);
    if (dem_grains_parse(world, "fuzz", data, size, &grains) == DEM_OK) {
        if (grains.count < 0 || !grains.positions || !grains.radii) abort();
        for (i = 0; i < grains.count; i++) if (!(grains.radii[i] > 0)) abort();
        dem_grains_add(world, stuff, &grains);      /* may refuse what is too large */
    } else if (grains.positions || grains.count || !dem_world_error_get(world)[0]) abort();
    dem_grains_free(world, &grains);
    dem_world_destroy(world);
    return 0;
}
