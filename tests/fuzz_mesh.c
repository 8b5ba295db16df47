/* fuzz_mesh.c - any bytes into dem_mesh_parse: it must refuse or read them, and never crash or leak.
   `make fuzz`; seeds are in tests/corpus/mesh. */
#define DEM_IMPLEMENTATION
#include "../dem.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_mesh mesh;
    dem_mesh_health health;
    dem_result result;
    int i;
    desc.threads = 1;
    world = dem_world_create(&desc);
    if (!world) return 0;
    result = dem_mesh_parse(world, "fuzz", data, size, &mesh, size%3 ? &health : 0);
    if (result == DEM_OK) {
        if (mesh.vertex_count < 1 || mesh.triangle_count < 1) abort();
        for (i = 0; i < 3*mesh.triangle_count; i++)
            if (mesh.triangles[i] < 0 || mesh.triangles[i] >= mesh.vertex_count) abort();
        for (i = 0; i < 3*mesh.vertex_count; i++)
            if (!(mesh.vertices[i] >= DEM_R(-1.01e15) && mesh.vertices[i] <= DEM_R(1.01e15))) abort();
    } else if (mesh.vertices || mesh.triangles || !dem_world_error_get(world)[0]) abort();
    dem_mesh_free(world, &mesh);
    dem_world_destroy(world);
    return 0;
}
