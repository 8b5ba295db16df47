/* fuzz_moldyn.c - any bytes into dem_moldyn_parse: the first byte says which of the three files, the
   rest is the file. It must refuse or read them, and never crash or leak; what it reads makes a world.
   `make fuzz`; seeds are in tests/corpus/moldyn. */
#define DEM_IMPLEMENTATION
#include "../dem.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_moldyn m = DEM_MOLDYN;
    dem_result result;
    int i;
    if (!size) return 0;
    desc.threads = 1;
    world = dem_world_create(&desc);
    if (!world) return 0;
    result = dem_moldyn_parse(world, "fuzz", (dem_moldyn_file)(data[0]%3), data + 1, size - 1, &m);
    if (result == DEM_OK) {
        for (i = 0; i < m.grain_count; i++)
            if (!(m.grains[14*i + 12] > 0)) abort();
        if (m.grain_count < 100 && m.wall_count < 100) {
            dem_world *made;
            if (!(m.stiffness > 0)) { m.stiffness = 1; m.density = 1; m.dt = 1; }
            desc = dem_moldyn_desc(&m);
            desc.threads = 1;
            made = dem_world_create(&desc);
            if (made && dem_moldyn_add(made, &m) != DEM_OK && !dem_world_error(made)[0]) abort();
            dem_world_destroy(made);
        }
    } else if (!dem_world_error(world)[0]) abort();
    dem_moldyn_free(&m);
    dem_world_destroy(world);
    return 0;
}
