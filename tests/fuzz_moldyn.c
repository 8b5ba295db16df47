/* fuzz_moldyn.c - any bytes into moldyn_parse: the first byte says which of the three files, the
   rest is the file. It must refuse or read them, and never crash or leak; what it reads makes a
   world, is taken from it, written and read back. `make fuzz`; seeds are in tests/corpus/moldyn. */
#define DEM_IMPLEMENTATION
#include "../examples/moldyn.h"

static void fail_unless(int right) { if (!right) abort(); }
static void same_outlines(const moldyn_outlines *a, const moldyn_outlines *b) {
    int i, all = a->count ? a->ends[a->count - 1] : 0;
    fail_unless(a->count == b->count);
    for (i = 0; i < a->count; i++) fail_unless(a->ends[i] == b->ends[i]);
    for (i = 0; i < 2*all; i++) fail_unless(a->corners[i] == b->corners[i]);
}
/* Written and read back, the rows are the same numbers. */
static void write_and_read(moldyn *m) {
    static const char cin[] = "build/fuzz_moldyn.cin", pin[] = "build/fuzz_moldyn.pin";
    static const char win[] = "build/fuzz_moldyn.win";
    moldyn n = MOLDYN;
    int i;
    fail_unless(moldyn_write(m, cin, pin, win) == DEM_OK);
    fail_unless(moldyn_read(&n, cin, pin, win) == DEM_OK);
    fail_unless(n.grain_count == m->grain_count && n.wall_count == m->wall_count);
    for (i = 0; i < 14*n.grain_count; i++) fail_unless(n.grains[i] == m->grains[i]);
    for (i = 0; i < 6*n.wall_count; i++) fail_unless(n.walls[i] == m->walls[i]);
    for (i = 0; i < n.grain_count; i++) fail_unless(moldyn_kind(&n, i) == moldyn_kind(m, i));
    same_outlines(&n.polygons, &m->polygons);
    same_outlines(&n.parts, &m->parts);
    same_outlines(&n.chains, &m->chains);
    fail_unless(n.start == m->start && n.stiffness_adhesion == m->stiffness_adhesion);
    moldyn_free(&n);
}
/* Into a world, and the grains out again. */
static void add_and_take(moldyn *m) {
    dem_world_desc desc;
    dem_world *world;
    const int count = m->grain_count;
    if (!(m->stiffness > 0)) { m->stiffness = 1; m->density = 1; m->dt = 1; }
    desc = moldyn_desc(m);
    desc.threads = 1;
    world = dem_world_create(&desc);
    if (!world) return;
    if (moldyn_add(m, world) == DEM_OK) {
        fail_unless(moldyn_take(m, world) == DEM_OK && m->grain_count == count);
        write_and_read(m);
    } else fail_unless(m->error[0] != 0);
    dem_world_destroy(world);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    moldyn m = MOLDYN;
    int i;
    if (!size) return 0;
    if (moldyn_parse(&m, "fuzz", (moldyn_file)(data[0]%3), data + 1, size - 1) == DEM_OK) {
        for (i = 0; i < m.grain_count; i++) fail_unless(m.grains[14*i + 12] > 0);
        if (m.grain_count < 100 && m.wall_count < 100 && m.polygons.count < 100 &&
            m.parts.count + m.chains.count < 100) add_and_take(&m);
    } else fail_unless(m.error[0] != 0 && !m.grains && !m.walls && !m.kinds && !m.polygons.ends &&
                       !m.parts.ends && !m.chains.ends);
    moldyn_free(&m);
    return 0;
}
