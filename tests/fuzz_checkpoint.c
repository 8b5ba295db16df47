/* fuzz_checkpoint.c - checkpoints with lies in them and a right check sum: they must be refused, or
   read and stepped, and never crash, hang or leak. `make fuzz`.

   A checkpoint is as memory lies on one machine, so there is no corpus: a good one is made here, and
   the input says what to change in it. Byte 0 chooses the scene's state and, when odd, the mode: the
   rest replaces the file behind its head, or is a row of changes of 7 bytes: place (3), value (4). */
#define DEM_IMPLEMENTATION
#include "../dem.h"

enum { STATES = 4 };
typedef struct good { char *data; size_t size; } good;

/* Spheres and clusters on a plane and a mesh, friction, feed, outlet, field. */
static dem_world *scene(int steps, int remove) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = DEM_MATERIAL_DESC;
    dem_cluster_desc two = DEM_CLUSTER_DESC;
    dem_feed_desc feed;
    dem_outlet_desc outlet;
    dem_field_desc field;
    dem_real corners[9] = {-1, -1, 0, 1, -1, 0, 0, 1, 0}, centres[6] = {0, 0, 0, DEM_R(5e-4), 0, 0};
    int32_t triangle[3] = {0, 1, 2};
    dem_mesh mesh = {3, 1, 0, 0};
    dem_material glass;
    dem_shape pair;
    dem_world *world;
    int i;
    mesh.vertices = corners;
    mesh.triangles = triangle;
    desc.threads = 1;
    desc.gravity.z = DEM_R(-9.81);
    world = dem_world_create(&desc);
    if (!world) return 0;
    stuff.density = 2500; stuff.young = DEM_R(1e6); stuff.poisson = DEM_R(0.25);
    stuff.restitution = stuff.friction = DEM_R(0.5);
    glass = dem_material_add(world, &stuff);
    dem_wall_plane_add(world, glass, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
    dem_wall_mesh_add(world, glass, &mesh);
    two.count = 2; two.positions = centres; two.radius = DEM_R(6e-4);
    pair = dem_shape_cluster_add(world, &two);
    for (i = 0; i < 20; i++) {
        const dem_vec3 x = dem_vec3_make(DEM_R(2e-3)*(dem_real)(i%3), DEM_R(2e-3)*(dem_real)(i/3%3),
                                         DEM_R(0.99e-3) + DEM_R(1.98e-3)*(dem_real)(i/9));
        if (i%5 == 4) dem_body_add(world, glass, pair, x, dem_quat_make(1, 0, 0, 0));
        else dem_sphere_add(world, glass, DEM_R(1e-3), x);
    }
    memset(&feed, 0, sizeof feed);
    feed.material = glass; feed.class_count = 1; feed.limited = 1; feed.rate = 100;
    feed.radius[0] = DEM_R(1e-3); feed.amount[0] = 5;
    feed.box = dem_box_make(0, 0, DEM_R(0.01), DEM_R(0.01), DEM_R(0.01), DEM_R(0.02));
    dem_feed_add(world, &feed);
    memset(&outlet, 0, sizeof outlet);
    outlet.box = dem_box_make(0, 0, -2, 1, 1, -1);
    dem_outlet_add(world, &outlet);
    memset(&field, 0, sizeof field);
    field.box = dem_box_make(0, 0, 0, 1, 1, 1);
    for (i = 0; i < 3; i++) field.cells[i] = 2;
    dem_field_add(world, &field);
    if (dem_world_step(world, steps) != DEM_OK) abort();
    if (remove) dem_body_remove(world, dem_body_id_get(world, 3));
    return world;
}
static good make(int state) {
    static const char path[] = "build/fuzz_checkpoint.dem";
    dem_world *world = scene(state ? 40 : 0, state > 1);
    good g = {0, 0};
    FILE *file;
    if (state == 3 && dem_world_step(world, 1) != DEM_OK) abort();
    if (dem_checkpoint_write(world, path) != DEM_OK) abort();
    dem_world_destroy(world);
    file = fopen(path, "rb");
    if (!file) abort();
    fseek(file, 0, SEEK_END);
    g.size = (size_t)ftell(file);
    rewind(file);
    g.data = (char *)malloc(g.size);
    if (!g.data || fread(g.data, 1, g.size, file) != g.size) abort();
    fclose(file);
    remove(path);
    return g;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static good goods[STATES];
    const int state = size ? data[0]/2%STATES : 0;
    const size_t head = sizeof(demi_checkpoint_head), end = sizeof(uint64_t);
    const good *g = &goods[state];
    size_t bytes, i;
    uint64_t sum;
    char *bad;
    dem_world *world;
    dem_result result;
    if (!g->data) goods[state] = make(state);
    bytes = g->size;
    if (size && data[0]%2) bytes = head + (size - 1) + end;
    bad = (char *)malloc(bytes);
    if (!bad) return 0;
    if (size && data[0]%2) {
        const uint64_t body = size - 1;
        memcpy(bad, g->data, head);
        memcpy(bad + offsetof(demi_checkpoint_head, body_size), &body, sizeof body);
        memcpy(bad + head, data + 1, size - 1);
    } else {
        memcpy(bad, g->data, bytes);
        for (i = 1; i + 7 <= size; i += 7) {
            const size_t place = (size_t)data[i] | (size_t)data[i + 1] << 8 |
                (size_t)data[i + 2] << 16;
            memcpy(bad + place%(bytes - end - 4), data + i + 3, 4);
        }
    }
    sum = demi_hash(DEMI_HASH_START, bad, bytes - end);
    memcpy(bad + bytes - end, &sum, end);
    world = scene(1, 0);
    if (!world) abort();
    result = demi_checkpoint_parse(world, "fuzz", bad, bytes, 0, 0);
    if (result != DEM_OK && !dem_world_error_get(world)[0]) abort();
    if (result != DEM_OK && dem_world_steps_get(world) != 1) abort();
    dem_world_hash_get(world);
    dem_contacts_get(world, 0, 0);
    result = dem_world_step(world, 20);
    if (result == DEM_OK) {
        dem_world_hash_get(world);
        dem_contacts_get(world, 0, 0);
    }
    dem_world_destroy(world);
    free(bad);
    return 0;
}
