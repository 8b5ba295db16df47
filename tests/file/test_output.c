/* What is done by hand in other codes: files on a schedule that a restart does not break, runs to a time and until
   at rest, velocities of a temperature. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static void file_name(char *name, const char *run, const char *rest) { sprintf(name, "build/tmp/output_%s%s", run, rest); }
/* All of a file; the caller frees it. Null: there is none. */
static char *file_text(const char *run, const char *rest, size_t *size) {
    char name[128], *text;
    FILE *f;
    file_name(name, run, rest);
    f = fopen(name, "rb");
    *size = 0;
    if (!f) return 0;
    fseek(f, 0, SEEK_END);
    *size = (size_t)ftell(f);
    rewind(f);
    text = (char *)calloc(*size + 1, 1);
    if (text && fread(text, 1, *size, f) != *size) *size = 0;
    fclose(f);
    return text;
}
static void files_equal(const char *a, const char *b, const char *rest) {
    size_t m, n;
    char *x = file_text(a, rest, &m), *y = file_text(b, rest, &n);
    CHECK(x && y && m > 0);
    CHECK(x && y && m == n && !memcmp(x, y, m));
    free(x);
    free(y);
}
static int file_lines(const char *run, const char *rest) {
    size_t n, i;
    char *text = file_text(run, rest, &n);
    int lines = 0;
    for (i = 0; i < n; i++) lines += text[i] == '\n';
    free(text);
    return lines;
}
static void fastest(const dem_world *world, double *values, void *user) {
    values[0] = (double)dem_counters_get(world).speed_max;
    values[1] = *(const double *)user;
}
static int count_call(dem_world *world, int64_t number, void *user) {
    int *calls = (int *)user;
    (void)world;
    calls[number < 15 ? number : 15]++;
    return 0;
}
static const double seven = 7;
static dem_world *heap(void) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material m;
    desc.gravity = at(0, 0, -9.81);
    world = dem_world_create(&desc);
    m = scene_material(world, 1e6, 0.5, 0.3, 0.1);
    dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
    dem_spheres_fill(world, m, DEM_R(0.005), dem_region_make(box_of(-0.03, -0.03, 0, 0.03, 0.03, 0.1)), 60, 1);
    return world;
}
static dem_world *scheduled(const char *run, int *calls) {
    dem_world *world = heap();
    dem_output_desc own = DEM_OUTPUT_DESC, loads = DEM_OUTPUT_DESC, call = DEM_OUTPUT_DESC;
    char name[128];
    file_name(name, run, ".csv");
    CHECK(dem_output_every_add(world, DEM_OUTPUT_CSV, name, 0.007).id == 1);
    file_name(name, run, "_##.vtp");
    CHECK(dem_output_every_add(world, DEM_OUTPUT_VTP, name, 0.05).id == 2);
    file_name(name, run, "_own.csv");
    own.kind = DEM_OUTPUT_CSV;
    own.path = name;
    own.interval = 0.01;
    own.start = 0.02;
    own.end = 0.15;
    own.columns = "fastest seven";
    own.values = fastest;
    own.user = (void *)&seven;
    CHECK(dem_output_add(world, &own).id == 3);
    file_name(name, run, "_floor.csv");
    loads.kind = DEM_OUTPUT_CSV;
    loads.path = name;
    loads.interval = 0.03;
    loads.wall.id = 1;
    CHECK(dem_output_add(world, &loads).id == 4);
    file_name(name, run, ".ckpt");
    CHECK(dem_output_every_add(world, DEM_OUTPUT_CHECKPOINT, name, 0.08).id == 5);
    call.interval = 0.02;
    call.function = count_call;
    call.user = calls;
    CHECK(dem_output_add(world, &call).id == 6);
    return world;
}
static int stop_at_two(dem_world *world, int64_t number, void *user) { (void)world; (void)user; return number == 2; }
static int steps_itself(dem_world *world, int64_t number, void *user) {
    (void)number;
    *(int *)user = dem_world_step(world, 1) == DEM_ERROR_ARGUMENT;
    return 0;
}
static int heats(dem_world *world, int64_t number, void *user) {
    (void)number; (void)user;
    return dem_temperature_set(world, 1e-2, 3) != DEM_OK;
}

/* One grain that each call of an output makes faster; the call comes before the checkpoint of the same step or
   after it. */
static int blow(dem_world *world, int64_t number, void *user) {
    const dem_body b = dem_body_id_get(world, 0);
    dem_body_state s = scene_state(world, b);
    (void)number;
    ++*(int *)user;
    s.velocity.x += DEM_R(0.1);
    return dem_body_set(world, b, &s) != DEM_OK;
}
static int refusing;                            /* 1: lone() gets no memory */
static void *alloc_lone(size_t size, void *user) { (void)user; return refusing ? 0 : malloc(size); }
static void free_lone(void *memory, size_t size, void *user) { (void)size; (void)user; free(memory); }
static int refuse_at_2(dem_world *world, int64_t count, void *user) {
    (void)world; (void)user;
    refusing = count == 2;
    return 0;
}
static dem_world *lone(void) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    desc.allocator.alloc_fn = alloc_lone;
    desc.allocator.free_fn = free_lone;
    desc.dt = DEM_R(1e-5);
    desc.threads = 1;
    world = dem_world_create(&desc);
    dem_sphere_add(world, scene_material(world, 1e6, 0.5, 0, 0), DEM_R(1e-3), at(0, 0, 0));
    return world;
}
static dem_output every(dem_world *world, double interval, int (*function)(dem_world *, int64_t, void *), void *user) {
    dem_output_desc d = DEM_OUTPUT_DESC;
    d.interval = interval;
    d.function = function;
    d.user = user;
    return dem_output_add(world, &d);
}
/* Four outputs; the second removes one of them at its second call. */
typedef struct removal { dem_output id[4]; int calls[4], victim; } removal;
static removal removing;
static int count_first(dem_world *w, int64_t n, void *u) { (void)w; (void)n; (void)u; removing.calls[0]++; return 0; }
static int count_second(dem_world *w, int64_t n, void *u) {
    (void)u;
    removing.calls[1]++;
    return n == 1 && dem_output_remove(w, removing.id[removing.victim]) != DEM_OK;
}
static int count_third(dem_world *w, int64_t n, void *u) { (void)w; (void)n; (void)u; removing.calls[2]++; return 0; }
static int count_fourth(dem_world *w, int64_t n, void *u) { (void)w; (void)n; (void)u; removing.calls[3]++; return 0; }
static dem_world *blown(int call_first, int *calls) {
    dem_world *world = lone();
    if (call_first) every(world, 1e-3, blow, calls);
    dem_output_every_add(world, DEM_OUTPUT_CHECKPOINT, "build/tmp/output_blown_#.ckpt", 1e-3);
    if (!call_first) every(world, 1e-3, blow, calls);
    return world;
}
static void back_to(dem_world *world, int number) {
    char name[64];
    sprintf(name, "build/tmp/output_blown_%d.ckpt", number);
    CHECK_EQ(dem_checkpoint_read(world, name), DEM_OK);
}
/* Adds twenty outputs at its first call, as many as make the list of them move. */
typedef struct adder { int calls, added[20]; } adder;
static int adds(dem_world *world, int64_t number, void *user) {
    adder *a = (adder *)user;
    int i;
    (void)number;
    if (a->calls++) return 0;
    for (i = 0; i < 20; i++) if (!every(world, 1e-3, count_call, a->added).id) return 1;
    return 0;
}
/* Goes back once. */
typedef struct returner { int back, calls[16]; } returner;
static int returns(dem_world *world, int64_t number, void *user) {
    returner *r = (returner *)user;
    count_call(world, number, r->calls);
    if (number != 6 || r->back++) return 0;
    return dem_checkpoint_read(world, "build/tmp/output_back.ckpt") != DEM_OK;
}
/* Goes back once, and stops the run. */
static int returns_and_stops(dem_world *world, int64_t number, void *user) {
    return returns(world, number, user) || (number == 6 && ((returner *)user)->back == 1);
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("walls with profiles are written on a schedule by kind, path and interval alone") {
        int k;
        for (k = 0; k < 4; k++) {       /* planar; a domain with a depth; bodies; nothing */
            static const double depth[4][2] = {{-0.1, 0.1}, {-3, 4}, {0.25, 0.85}, {0, 1}};
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_real corners[4] = {0, 0, 1, 0}, at_z[4];
            int32_t ends[2] = {0, 1};
            dem_profile line;
            dem_world *w;
            dem_material m;
            const char *data;
            char *text;
            size_t n;
            int i;
            desc.dt = DEM_R(1e-4);
            desc.planar = k == 0;
            desc.thickness = k ? 0 : DEM_R(0.2);
            if (k == 1) desc.domain = box_of(-1, -1, -3, 1, 1, 4);
            w = dem_world_create(&desc);
            m = scene_material(w, 1e6, 0.5, 0.5, 0);
            line.vertex_count = 2; line.vertices = corners;
            line.segment_count = 1; line.segments = ends;
            dem_wall_profile_add(w, m, &line, DEM_EDGE_RESOLVED);
            if (k != 3) dem_sphere_add(w, m, DEM_R(0.05), at(0.5, 0.5, k == 0 ? 0 : 0.3));
            if (k != 3) dem_sphere_add(w, m, DEM_R(0.1), at(0.5, 0.9, k == 0 ? 0 : 0.75));
            CHECK(dem_output_every_add(w, DEM_OUTPUT_WALLS, "build/tmp/output_profile_##.vtp", 1e-3).id != 0);
            CHECK_EQ(dem_world_run(w, 1e-3, 0, 0), DEM_OK);
            text = file_text("profile", "_01.vtp", &n);
            data = text ? strstr(text, "<AppendedData encoding=\"raw\">\n_") : 0;
            CHECK(data != 0);
            for (i = 0; i < 4 && data; i++)
                memcpy(&at_z[i], data + strlen("<AppendedData encoding=\"raw\">\n_") + 8 + (size_t)(3*i + 2)*sizeof(dem_real),
                       sizeof(dem_real));
            for (i = 0; i < 4 && data; i++) CHECK_NEAR((double)at_z[i], depth[k][i >= 2], 1e-3);
            free(text);
            dem_world_destroy(w);
        }
    }
    TEST("the function of an output removes any output, also its own, and no other output misses a call") {
        static int (*const functions[4])(dem_world *, int64_t, void *) = {count_first, count_second, count_third, count_fourth};
        int victim, k;
        for (victim = 0; victim < 4; victim++) {
            dem_world *world = lone();
            memset(&removing, 0, sizeof removing);
            removing.victim = victim;
            for (k = 0; k < 4; k++) removing.id[k] = every(world, 1e-3, functions[k], 0);
            CHECK_EQ(dem_world_run(world, 4e-3, 0, 0), DEM_OK);
            for (k = 0; k < 4; k++) CHECK_EQ(removing.calls[k], k != victim ? 5 : victim < 2 ? 2 : 1);
            CHECK_EQ(dem_output_remove(world, removing.id[victim]), DEM_ERROR_ARGUMENT);
            CHECK_STR(dem_world_error_get(world), "dem_output_remove: output");
            CHECK_EQ(every(world, 1e-3, count_first, 0).id, 5);          /* ids are never used again */
            dem_world_destroy(world);
        }
    }
    TEST("a scheduled call runs once, also if a checkpoint is written or read at its step") {
        int first, from;
        for (first = 0; first < 2; first++)
            for (from = 0; from < 4; from++) {
                int whole = 0, again = 0;
                dem_world *a = blown(first, &whole), *b = blown(first, &again);
                CHECK_EQ(dem_world_run_to(a, 4e-3, 0, 0), DEM_OK);
                CHECK_EQ(whole, 5);
                back_to(b, from);
                CHECK_EQ(dem_world_run_to(b, 4e-3, 0, 0), DEM_OK);
                CHECK_EQ(again, 5 - from - first);
                CHECK_EQ(dem_world_hash_get(a), dem_world_hash_get(b));
                dem_world_destroy(a);
                dem_world_destroy(b);
            }
    }
    TEST("outputs that a restart adds, omits or reschedules continue from the step of the checkpoint") {
        int calls = 0, more[16] = {0}, k;
        dem_world *world = blown(1, &calls);
        CHECK_EQ(dem_world_run_to(world, 4e-3, 0, 0), DEM_OK);
        dem_world_destroy(world);
        world = lone();                          /* none */
        back_to(world, 3);
        CHECK_EQ(dem_world_run_to(world, 4e-3, 0, 0), DEM_OK);
        dem_world_destroy(world);
        world = lone();                          /* its interval halved; and one that the file does not know */
        calls = 0;
        every(world, 5e-4, blow, &calls);
        every(world, 1e-3, count_call, more);
        back_to(world, 2);
        CHECK_EQ(dem_world_run_to(world, 4e-3, 0, 0), DEM_OK);
        CHECK_EQ(more[2] + more[3] + more[4], 2);          /* exactly its own times: it takes over what was made */
        CHECK_EQ(more[2], 0);
        CHECK_EQ(calls, 5);                      /* 2 (nothing of the file is left for it), 2.5, .. 4 ms */
        dem_world_destroy(world);
        world = lone();
        calls = 0;
        every(world, 5e-4, blow, &calls);
        back_to(world, 2);
        CHECK_EQ(dem_world_run_to(world, 4e-3, 0, 0), DEM_OK);
        CHECK_EQ(calls, 4);                      /* 2.5, 3, 3.5, 4 ms: that of 2 ms is in the file */
        dem_world_destroy(world);
        for (k = 0; k < 5; k++) {
            char name[64];
            sprintf(name, "build/tmp/output_blown_%d.ckpt", k);
            remove(name);
        }
    }
    TEST("a scheduled call may add outputs, which start at once, and read a checkpoint, whose outputs return") {
        adder a;
        returner r;
        int other[16] = {0}, k;
        dem_world *world = lone();
        memset(&a, 0, sizeof a);
        memset(&r, 0, sizeof r);
        every(world, 1e-3, adds, &a);
        CHECK_EQ(dem_world_run_to(world, 2e-3, 0, 0), DEM_OK);
        CHECK_EQ(a.calls, 3);
        for (k = 0; k < 4; k++) CHECK_EQ(a.added[k], k < 3 ? 20 : 0);
        dem_world_destroy(world);
        world = lone();
        every(world, 1e-3, returns, &r);
        every(world, 1e-3, count_call, other);
        CHECK_EQ(dem_world_run_to(world, 2.5e-3, 0, 0), DEM_OK);
        CHECK_EQ(dem_checkpoint_write(world, "build/tmp/output_back.ckpt"), DEM_OK);
        CHECK_EQ(dem_world_run_to(world, 8e-3, 0, 0), DEM_OK);
        for (k = 0; k <= 8; k++) CHECK_EQ(r.calls[k], k >= 3 && k <= 6 ? 2 : 1);
        for (k = 0; k <= 8; k++) CHECK_EQ(other[k], k >= 3 && k <= 5 ? 2 : 1);     /* 6: it had not come yet */
        CHECK_NEAR(dem_world_time_get(world), 8e-3, 1e-9);
        dem_world_destroy(world);
        remove("build/tmp/output_back.ckpt");
    }
    TEST("a scheduled function that reads a checkpoint can stop the run, and no output misses a call afterwards") {
        returner r;
        int other[16] = {0}, k;
        dem_world *world = lone();
        memset(&r, 0, sizeof r);
        every(world, 1e-3, count_call, other);
        every(world, 1e-3, returns_and_stops, &r);
        CHECK_EQ(dem_world_run_to(world, 2.5e-3, 0, 0), DEM_OK);
        CHECK_EQ(dem_checkpoint_write(world, "build/tmp/output_back.ckpt"), DEM_OK);
        CHECK_EQ(dem_world_run_to(world, 8e-3, 0, 0), DEM_ERROR_STOPPED);
        CHECK_STR(dem_world_error_get(world), "stopped by the function of an output");
        CHECK_NEAR(dem_world_time_get(world), 2.5e-3, 1e-9);
        CHECK_EQ(dem_world_run_to(world, 8e-3, 0, 0), DEM_OK);
        for (k = 0; k <= 8; k++) {
            CHECK_EQ(other[k], k >= 3 && k <= 6 ? 2 : 1);
            CHECK_EQ(r.calls[k], k >= 3 && k <= 6 ? 2 : 1);
        }
        dem_world_destroy(world);
        remove("build/tmp/output_back.ckpt");
    }
    TEST("an output of a wall that is removed stops the run with its number, and the run goes on without it") {
        dem_world *world = lone();
        dem_output_desc d = DEM_OUTPUT_DESC;
        dem_material m;
        dem_output output;
        m.id = 1;
        d.kind = DEM_OUTPUT_CSV;
        d.path = "build/tmp/output_wall.csv";
        d.interval = 1e-4;
        d.wall = dem_wall_plane_add(world, m, at(0, 0, -1), at(0, 0, 1));
        output = dem_output_add(world, &d);
        CHECK_EQ(dem_world_step(world, 30), DEM_OK);
        CHECK_EQ(dem_wall_remove(world, d.wall), DEM_OK);
        dem_wall_plane_add(world, m, at(0, 0, -2), at(0, 0, 1));       /* in its place */
        CHECK_EQ(dem_world_step(world, 30), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "output 1 writes the loads of wall 1, which was removed; remove the output too");
        CHECK_EQ(dem_output_remove(world, output), DEM_OK);
        CHECK_EQ(dem_world_step(world, 30), DEM_OK);
        dem_world_destroy(world);
        remove(d.path);
    }
    TEST("a scheduled CSV file of an outlet has the grains and masses that it has removed") {
        dem_world *world = heap();
        dem_outlet_desc mouth = DEM_OUTLET_DESC;
        dem_outlet_state state;
        dem_output_desc d = DEM_OUTPUT_DESC;
        char *text, last[256];
        size_t n;
        mouth.box = box_of(-1, -1, -1, 1, 1, 0.02);
        mouth.wanted_min = DEM_R(0.006); mouth.wanted_max = DEM_R(0.007);  /* m: no grain, so all are gangue */
        d.kind = DEM_OUTPUT_CSV;
        d.path = "build/tmp/output_outlet.csv";
        d.interval = 0.01;
        d.outlet.id = 1;
        CHECK(dem_output_add(world, &d).id == 0);
        CHECK_STR(dem_world_error_get(world), "outlet does not exist");
        d.outlet = dem_outlet_add(world, &mouth);
        d.wall.id = 1;
        CHECK(dem_output_add(world, &d).id == 0);
        CHECK_STR(dem_world_error_get(world), "more than one of wall, outlet, mixing and values");
        d.wall.id = 0;
        CHECK(dem_output_add(world, &d).id == 1);
        CHECK_EQ(dem_world_run(world, 0.1, 0, 0), DEM_OK);
        CHECK_EQ(dem_outlet_get(world, d.outlet, &state), DEM_OK);
        CHECK(state.total > 5 && state.total < 60 && state.gangue == state.total);
        text = file_text("outlet", ".csv", &n);
        CHECK(text && !strncmp(text, "time,grains,mass,sorted,sorted_mass,gangue,gangue_mass,back,back_mass,held,held_mass\n", 84));
        sprintf(last, ",%d,%.9g,0,0,%d,%.9g,0,0,0,0\n", (int)state.total, state.total_mass, (int)state.gangue, state.gangue_mass);
        CHECK(text && n > strlen(last) && !strcmp(text + n - strlen(last), last));
        free(text);
        dem_world_destroy(world);
        remove(d.path);
    }
    TEST("a CSV file holds no line of an earlier run, and after a restart those up to the checkpoint") {
        int late;
        for (late = 0; late < 2; late++) {
            dem_world *world = lone();
            dem_output_desc d = DEM_OUTPUT_DESC;
            d.kind = DEM_OUTPUT_CSV;
            d.path = "build/tmp/output_late.csv";
            d.interval = 1e-3;
            dem_output_add(world, &d);
            CHECK_EQ(dem_world_run_to(world, 9e-3, 0, 0), DEM_OK);
            CHECK_EQ(file_lines("late", ".csv"), 1 + 10);
            dem_world_destroy(world);
            world = lone();                      /* begins at 3 ms: by its start, or since it is added then */
            if (late) CHECK_EQ(dem_world_run_to(world, 3e-3, 0, 0), DEM_OK);
            else d.start = 3e-3;
            dem_output_add(world, &d);
            CHECK_EQ(dem_world_run_to(world, 5e-3, 0, 0), DEM_OK);
            CHECK_EQ(file_lines("late", ".csv"), 1 + 3);
            CHECK_EQ(dem_checkpoint_write(world, "build/tmp/output_late.ckpt"), DEM_OK);
            CHECK_EQ(dem_world_run_to(world, 8e-3, 0, 0), DEM_OK);
            CHECK_EQ(file_lines("late", ".csv"), 1 + 6);
            dem_world_destroy(world);
            world = lone();
            d.interval = 5e-4;                   /* other times, the same file */
            dem_output_add(world, &d);
            CHECK_EQ(dem_checkpoint_read(world, "build/tmp/output_late.ckpt"), DEM_OK);
            CHECK_EQ(dem_world_run_to(world, 6e-3, 0, 0), DEM_OK);
            CHECK_EQ(file_lines("late", ".csv"), 1 + 5);
            dem_world_destroy(world);
        }
        remove("build/tmp/output_late.ckpt");
        remove("build/tmp/output_late.csv");
    }
    TEST("an output that cannot be written stops the run, and the next run writes it") {
        int kind;
        for (kind = DEM_OUTPUT_VTP; kind <= DEM_OUTPUT_SURFACES; kind++) {
            dem_world *world = lone();
            char name[64];
            sprintf(name, "build/tmp/output_folder_%d/a", kind);
            CHECK(dem_output_every_add(world, (dem_output_kind)kind, name, 1e-3).id == 1);
            CHECK_EQ(dem_world_run(world, 2e-3, 0, 0), DEM_ERROR_FILE);
            CHECK_EQ(dem_world_run(world, 2e-3, 0, 0), DEM_ERROR_FILE);   /* nor does it now; not: "did not start" */
            CHECK_STR(dem_world_error_get(world), name);
            CHECK_EQ(dem_world_steps_get(world), 0);
            dem_world_destroy(world);
        }
    }
    TEST("an output that fails at the end of a run is written by the next call, also by one of 0 steps") {
        dem_world *world = lone();
        size_t n;
        char *text;
        every(world, 1e-3, refuse_at_2, 0);
        remove("build/tmp/output_late_0002.vtp");
        CHECK(dem_output_every_add(world, DEM_OUTPUT_VTP, "build/tmp/output_late_####.vtp", 1e-3).id == 2);
        CHECK_EQ(dem_world_step(world, 0), DEM_OK);            /* nothing is due before the first step */
        CHECK_EQ(dem_world_step(world, 200), DEM_ERROR_MEMORY);
        CHECK_EQ(dem_world_steps_get(world), 200);
        refusing = 0;
        CHECK_EQ(dem_world_step(world, 0), DEM_OK);
        text = file_text("late_0002", ".vtp", &n);
        CHECK(text && n > 0);
        free(text);
        dem_world_destroy(world);
    }
    TEST("an interval too short for its time or its count is rejected") {
        dem_world *world = lone();
        int calls = 0;
        CHECK(every(world, 1e-30, blow, &calls).id == 0);
        CHECK_STR(dem_world_error_get(world), "dem_output_add: interval must be 1e-12 to 1e15 s");
        CHECK(every(world, 1e16, blow, &calls).id == 0);
        CHECK(every(world, (double)NAN, blow, &calls).id == 0);
        {
            dem_output_desc d = DEM_OUTPUT_DESC;
            d.function = blow;
            d.user = &calls;
            d.interval = 1e-6;
            d.start = -1e12;
            CHECK(dem_output_add(world, &d).id == 0);
            CHECK_STR(dem_world_error_get(world), "9e15 intervals");
            d.start = 1e16;
            CHECK(dem_output_add(world, &d).id == 0);
        }
        CHECK(every(world, 1e-12, blow, &calls).id == 1);
        CHECK_EQ(dem_world_step(world, 3), DEM_OK);
        CHECK_EQ(calls, 4);                      /* at every step, the first included */
        dem_world_destroy(world);
    }

    TEST("a run that is killed and resumes from its checkpoint leaves the files of an uninterrupted one") {
        int whole[16] = {0}, parts[16] = {0}, k;
        char name[128];
        dem_world *a = scheduled("whole", whole), *b = scheduled("parts", parts);
        CHECK_EQ(dem_world_run_to(a, 0.2, 0, 0), DEM_OK);
        CHECK_EQ(dem_world_run_to(b, 0.137, 0, 0), DEM_OK);   /* beyond the checkpoint of .08 s, then killed */
        dem_world_destroy(b);
        b = scheduled("parts", parts);
        file_name(name, "parts", ".ckpt");
        CHECK_EQ(dem_checkpoint_read(b, name), DEM_OK);
        CHECK_NEAR(dem_world_time_get(b), 0.08, (double)dem_counters_get(b).dt);
        CHECK_EQ(dem_world_run_to(b, 0.2, 0, 0), DEM_OK);
        CHECK(dem_world_hash_get(a) == dem_world_hash_get(b));
        files_equal("whole", "parts", ".csv");
        files_equal("whole", "parts", "_own.csv");
        files_equal("whole", "parts", "_floor.csv");
        files_equal("whole", "parts", "_00.vtp");
        files_equal("whole", "parts", "_04.vtp");
        CHECK_EQ(file_lines("whole", ".csv"), 1 + 29);       /* 0, .007 .. .196 s, and the heading */
        CHECK_EQ(file_lines("whole", "_own.csv"), 1 + 14);   /* .02 to .15 s */
        CHECK_EQ(file_lines("whole", "_floor.csv"), 1 + 7);
        for (k = 0; k <= 10; k++) CHECK_EQ(whole[k], 1);
        /* after the checkpoint, which was added before the call, it had come at .08, .1 and .12 s before the kill */
        for (k = 0; k <= 10; k++) CHECK_EQ(parts[k], k >= 4 && k <= 6 ? 2 : 1);
        dem_world_destroy(a);
        dem_world_destroy(b);
        /* the program, run again from its beginning, writes its files again */
        a = scheduled("whole", whole);
        CHECK_EQ(dem_world_run_to(a, 0.05, 0, 0), DEM_OK);
        CHECK_EQ(file_lines("whole", ".csv"), 1 + 8);
        dem_world_destroy(a);
    }

    TEST("bad outputs fail by name, a file with other columns stays, and a failed write stops the run, which can "
         "continue") {
        dem_world *world = heap();
        dem_output_desc d = DEM_OUTPUT_DESC;
        dem_counters before;
        size_t n;
        char *text;
        FILE *f = fopen("build/tmp/output_other.csv", "wb");
        CHECK(f != 0);
        if (f) { fputs("time,tea\n1,2\n", f); fclose(f); }
        CHECK(dem_output_add(world, &d).id == 0);            /* no interval */
        CHECK_STR(dem_world_error_get(world), "interval must be 1e-12 to 1e15 s");
        d.interval = 0.01;
        CHECK(dem_output_add(world, &d).id == 0);
        CHECK_STR(dem_world_error_get(world), "function is null");
        d.kind = DEM_OUTPUT_VTP;
        CHECK(dem_output_add(world, &d).id == 0);
        CHECK_STR(dem_world_error_get(world), "path is null");
        d.kind = DEM_OUTPUT_CSV;
        d.path = "build/tmp/output_#.csv";
        CHECK(dem_output_add(world, &d).id == 0);
        CHECK_STR(dem_world_error_get(world), "leave the # out");
        d.path = "build/tmp/output_other.csv";
        d.columns = "b c";
        CHECK(dem_output_add(world, &d).id == 0);
        CHECK_STR(dem_world_error_get(world), "columns and values");
        d.columns = 0;
        d.wall.id = 9;
        CHECK(dem_output_add(world, &d).id == 0);
        CHECK_STR(dem_world_error_get(world), "wall does not exist");
        d.wall.id = 0;
        CHECK(dem_output_every_add(0, DEM_OUTPUT_CSV, "x", 1).id == 0);
        CHECK(dem_output_add(world, &d).id == 1);
        before = dem_counters_get(world);
        CHECK_EQ(dem_world_run(world, 0.02, 0, 0), DEM_ERROR_FORMAT);
        CHECK_STR(dem_world_error_get(world), "other columns");
        CHECK_EQ(dem_counters_get(world).steps, before.steps);
        text = file_text("other", ".csv", &n);
        CHECK(text && !strcmp(text, "time,tea\n1,2\n"));
        free(text);
        remove("build/tmp/output_other.csv");
        CHECK_EQ(dem_world_run(world, 0.02, 0, 0), DEM_OK);
        CHECK_EQ(file_lines("other", ".csv"), 1 + 3);
        dem_world_destroy(world);
    }

    TEST("a scheduled function can stop a run and change the world, but not step it") {
        dem_world *world = heap();
        dem_output_desc d = DEM_OUTPUT_DESC;
        int refused = 0;
        d.interval = 0.01;
        d.function = stop_at_two;
        dem_output_add(world, &d);
        CHECK_EQ(dem_world_run(world, 1, 0, 0), DEM_ERROR_STOPPED);
        CHECK_NEAR(dem_world_time_get(world), 0.02, (double)dem_counters_get(world).dt);
        dem_world_destroy(world);
        world = heap();
        d.function = steps_itself;
        d.user = &refused;
        dem_output_add(world, &d);
        CHECK_EQ(dem_world_run(world, 0.005, 0, 0), DEM_OK);
        CHECK(refused);
        CHECK_STR(dem_world_error_get(world), "runs between two steps");
        dem_world_destroy(world);
        world = heap();
        d.function = heats;
        dem_output_add(world, &d);
        CHECK_EQ(dem_world_run_to(world, 0.03, 0, 0), DEM_OK);
        CHECK_NEAR(dem_temperature_get(world), 1e-2, 1e-8);
        dem_world_destroy(world);
    }

    TEST("dem_world_run_to ends at its time from any start, and does not run backwards") {
        dem_world *world = heap();
        dem_real dt;
        CHECK_EQ(dem_world_step(world, 17), DEM_OK);
        dt = dem_counters_get(world).dt;
        CHECK_EQ(dem_world_run_to(world, 0.05, 0, 0), DEM_OK);
        CHECK_NEAR(dem_world_time_get(world), 0.05, 0.51*(double)dt);
        CHECK_EQ(dem_world_step(world, 3), DEM_OK);
        CHECK_EQ(dem_world_run_to(world, 0.07, 0, 0), DEM_OK);
        CHECK_NEAR(dem_world_time_get(world), 0.07, 0.51*(double)dt);
        CHECK_EQ(dem_world_run_to(world, 0.07, 0, 0), DEM_OK);
        CHECK_EQ(dem_world_run_to(world, 0.06, 0, 0), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "not before now");
        CHECK_NEAR(dem_world_time_get(world), 0.07, 0.51*(double)dt);
        dem_world_destroy(world);
    }

    TEST("dem_world_settle ends with a heap at rest; a ball at its apex and a lossless one are not at rest") {
        dem_world *world = heap();
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_material m;
        CHECK_EQ(dem_world_settle(world, 5, 0, 0, 0), DEM_OK);
        CHECK(dem_world_time_get(world) > 0.1 && dem_world_time_get(world) < 5);
        CHECK((double)dem_counters_get(world).speed_max < 0.1*sqrt(2*9.81*0.005));
        dem_world_destroy(world);
        desc.gravity = at(0, 0, -9.81);
        world = dem_world_create(&desc);
        m = scene_material(world, 1e7, 1, 0, 0);
        dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        dem_sphere_add(world, m, DEM_R(0.005), at(0, 0, 0.05));
        CHECK_EQ(dem_world_settle(world, 2, 0, 0, 0), DEM_ERROR_STOPPED);
        CHECK_STR(dem_world_error_get(world), "not at rest after 2 s");
        CHECK_NEAR(dem_world_time_get(world), 2, 1e-3);
        CHECK_EQ(dem_world_settle(world, 0, 0, 0, 0), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "both must be finite");
        dem_world_destroy(world);
        world = dem_world_create(&desc);                /* a ball that begins to fall is slow for a while */
        m = scene_material(world, 1e7, 1, 0, 0);
        dem_sphere_add(world, m, DEM_R(0.005), at(0, 0, 1));
        CHECK_EQ(dem_world_settle(world, 1e-4, 0, 0, 0), DEM_ERROR_STOPPED);
        CHECK_STR(dem_world_error_get(world), "too short: rest takes three tests, 0.0226 s apart; allow at least 0.05 s");
        dem_world_destroy(world);
        desc.gravity = at(0, 0, 0);
        world = dem_world_create(&desc);
        m = scene_material(world, 1e7, 0.5, 0, 0);
        CHECK_EQ(dem_world_settle(world, 1, 0, 0, 0), DEM_OK);   /* nobody there: at rest */
        dem_sphere_add(world, m, DEM_R(0.005), at(0, 0, 0.05));
        CHECK_EQ(dem_world_settle(world, 1, 0, 0, 0), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "without gravity");
        CHECK_EQ(dem_world_settle(world, 1, DEM_R(1e-3), 0, 0), DEM_OK);
        dem_world_destroy(world);
    }
    TEST("dem_world_settle ends after a time that is no multiple of the step") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        int k;
        desc.gravity = at(0, 0, -9.81);
        desc.dt = DEM_R(1e-5);
        world = dem_world_create(&desc);
        dem_sphere_add(world, scene_material(world, 1e6, 0.5, 0, 0), DEM_R(1e-3), at(0, 0, 1));
        for (k = 1; k < 20; k++)
            CHECK_EQ(dem_world_settle(world, 1.03e-5*k, DEM_R(1e-6), 0, 0), DEM_ERROR_STOPPED);
        dem_world_destroy(world);
    }

    TEST("a time is as many steps for dem_world_settle as for dem_world_run, whatever ran before") {
        int way, steps, k;
        for (steps = 1; steps <= 60; steps++)
            for (way = 0; way < 3; way++) {
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_world *world;
                desc.response = DEM_RESPONSE_IMPULSES;
                desc.gravity = at(0, 0, -9.81);
                desc.dt = DEM_R(1e-4);
                world = dem_world_create(&desc);
                dem_sphere_add(world, scene_material(world, 1e6, 0.5, 0, 0), 1, at(0, 0, 0));
                CHECK_EQ(scene_step(world, 1), DEM_OK);
                for (k = 0; k < 8; k++) {      /* in turn so many steps and one */
                    const double time = (k%2 ? 1 : steps)*(double)desc.dt;
                    if (way == 2) CHECK_EQ(dem_world_settle(world, time, DEM_R(1e-12), 0, 0), DEM_ERROR_STOPPED);
                    else if (way) CHECK_EQ(dem_world_run_to(world, dem_world_time_get(world) + time, 0, 0), DEM_OK);
                    else CHECK_EQ(dem_world_run(world, time, 0, 0), DEM_OK);
                    CHECK_EQ(dem_world_steps_get(world), (uint64_t)(1 + k/2*(steps + 1) + steps + k%2));
                }
                if (test_now.wrong) printf("        way %d, %d steps\n", way, steps);
                dem_world_destroy(world);
            }
    }
    TEST("an output that starts less than half a step from the beginning is written there, however the run steps") {
        int way;
        for (way = 0; way < 3; way++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_output_desc out = DEM_OUTPUT_DESC;
            dem_world *world;
            char text[200] = "";
            FILE *f;
            desc.gravity = at(0, 0, -9.81);
            desc.dt = DEM_R(4e-4);
            world = dem_world_create(&desc);
            dem_sphere_add(world, scene_material(world, 1e3, 0.5, 0, 0), DEM_R(1e-3), at(0, 0, 0));
            out.kind = DEM_OUTPUT_CSV;
            out.path = "build/tmp/start.csv";
            out.interval = 9e-3;
            out.start = 1e-4;
            CHECK(dem_output_add(world, &out).id > 0);
            if (way == 2) CHECK_EQ(dem_world_settle(world, 4e-4, DEM_R(1e-12), 0, 0), DEM_ERROR_STOPPED);
            else CHECK_EQ(way ? dem_world_run(world, 4e-4, 0, 0) : dem_world_step(world, 1), DEM_OK);
            f = fopen(out.path, "rb");
            if (f) { text[fread(text, 1, sizeof text - 1, f)] = 0; fclose(f); }
            CHECK(strstr(text, "\n0,0,1,"));    /* time 0, step 0, one body */
            CHECK_EQ(dem_world_steps_get(world), 1u);
            dem_world_destroy(world);
            remove(out.path);
        }
    }

    TEST("dem_temperature_set gives the temperature, keeps the mean velocity, shares energy evenly, and enters the "
         "ledger") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material m;
        dem_body_state s, s2;
        dem_totals t;
        double share[2] = {0, 0};
        int i;
        uint64_t rest = 5;
        desc.ledger = 1;
        world = dem_world_create(&desc);
        m = scene_material(world, 1e6, 0.9, 0, 0);
        for (i = 0; i < 2000; i++) {
            const dem_vec3 x = scene_at(&rest, 1, 0, 1, 0, 1, 0);
            const dem_body b = dem_sphere_add(world, m, (dem_real)(i & 1 ? 1e-3 : 2e-3), x);
            scene_move(world, b, at(0.3, 0, -0.1), at(0, 0, 0));
        }
        CHECK_NEAR(dem_temperature_get(world), 0, 1e-12);
        CHECK_EQ(dem_temperature_set(world, 0.04, 0), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "give a seed");
        CHECK_EQ(dem_temperature_set(world, -1, 3), DEM_ERROR_ARGUMENT);
        CHECK_EQ(dem_temperature_set(world, 0.04, 3), DEM_OK);
        CHECK_REL(dem_temperature_get(world), 0.04, 1e-5);
        t = dem_totals_get(world);
        CHECK_REL(t.momentum[0]/t.mass, 0.3, 1e-5);
        CHECK_REL(t.momentum[2]/t.mass, -0.1, 1e-5);
        for (i = 0; i < 2000; i++) {
            s = scene_state(world, dem_body_id_get(world, i));
            s.velocity = at((double)s.velocity.x - 0.3, (double)s.velocity.y, (double)s.velocity.z + 0.1);
            share[(double)s.radius > 1.5e-3] += (double)(s.mass*demi_dot(s.velocity, s.velocity));
        }
        CHECK_REL(share[1], share[0], 5*sqrt(2.0/3000 + 2.0/3000));   /* 3 x 1000 draws each: 5 standard errors */
        s = scene_state(world, dem_body_id_get(world, 7));
        CHECK_EQ(dem_temperature_set(world, 0.01, 0), DEM_OK);
        s2 = scene_state(world, dem_body_id_get(world, 7));
        CHECK_REL(dem_temperature_get(world), 0.01, 1e-5);
        CHECK_NEAR((double)s2.velocity.y, (double)s.velocity.y/2, 1e-6);
        CHECK_EQ(dem_world_step(world, 10), DEM_OK);
        CHECK_NEAR(dem_ledger_get(world).residual, 0, 1e-5*dem_ledger_get(world).throughput);
        CHECK_EQ(dem_temperature_set(world, 0, 0), DEM_OK);
        CHECK_NEAR(dem_temperature_get(world), 0, 1e-12);
        dem_world_destroy(world);
    }
    return test_end();
}
