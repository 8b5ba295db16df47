/* fuzz_profile.c - any bytes into dem_profile_parse: it must refuse or read them, and never crash or leak.
   `make fuzz`; seeds are in tests/corpus/profile. */
#define DEM_IMPLEMENTATION
#include "../dem.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_profile profile;
    dem_result result;
    int i;
    desc.threads = 1;
    world = dem_world_create(&desc);
    if (!world) return 0;
    result = dem_profile_parse(world, "fuzz", data, size, &profile);
    if (result == DEM_OK) {
        if (profile.vertex_count < 1 || profile.segment_count < 1) abort();
        for (i = 0; i < 2*profile.segment_count; i++)
            if (profile.segments[i] < 0 || profile.segments[i] >= profile.vertex_count) abort();
        for (i = 0; i < 2*profile.vertex_count; i++)
            if (!(profile.vertices[i] >= DEM_R(-1.01e15) && profile.vertices[i] <= DEM_R(1.01e15))) abort();
    } else if (profile.vertices || profile.segments || !dem_world_error_get(world)[0]) abort();
    dem_profile_free(world, &profile);
    dem_world_destroy(world);
    return 0;
}
