/* How many threads a world uses: its desc says how many at most, and the times of steps decide. Times are made up here,
   so that no other program on the machine can change them. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

/* The time of a step with n threads, s: alone on the machine; beside another program on every core; with so few grains that
   threads only cost. */
static double quiet(int n) { return 1e-3*(0.1 + 0.9/n); }
static double busy(int n) { return n > 1 ? 20e-3 : 1e-3; }
static double few(int n) { return 1e-4*(1 + 0.3*(n - 1)); }
static dem_world *world_of(int threads) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *w;
    desc.threads = threads;
    desc.gravity = at(0, 0, -9.81);
    w = dem_world_create(&desc);
    w->threads.fixed = 0;
    return w;
}
/* Lets a world make steps of which each takes such a time. Every `rebuild`th step rebuilds and takes ten times as long.
   Returns the total, s. */
static double make_steps(dem_world *w, int steps, double (*time)(int threads), int rebuild) {
    double total = 0;
    int i;
    for (i = 0; i < steps; i++) {
        double t;
        demi_threads_begin(w);
        t = time(w->threads.now);
        CHECK(w->threads.now >= 1 && w->threads.now <= w->desc.threads);
        if (rebuild && i%rebuild == 0) { w->clock.rebuilds++; t *= 10; }
        if (demi_threads_varies(w)) demi_threads_judge(w, t);
        total += t;
    }
    return total;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("number of threads: a world uses all threads where they are fastest, one where they only cost, and loses few per cent by trials") {
        static double (*const times[3])(int) = {quiet, busy, few};
        static const int most[4] = {2, 6, 8, 64};
        int k, m, rebuild;
        for (k = 0; k < 3; k++)
            for (m = 0; m < 4; m++)
                for (rebuild = 0; rebuild < 40; rebuild += 13) {
                    dem_world *w = world_of(most[m]);
                    const int right = k ? 1 : most[m];
                    const double took = make_steps(w, 20000, times[k], rebuild);
                    const double least = 20000*times[k](right)*(rebuild ? 1 + 9.0/rebuild : 1);
                    CHECK_EQ(w->threads.best, right);
                    CHECK(took < 1.05*least);
                    dem_world_destroy(w);
                }
    }

    TEST("number of threads: when another program begins to keep the cores busy a world falls back to one thread at once, and returns "
         "when it ends") {
        dem_world *w = world_of(4);
        make_steps(w, 2000, quiet, 0);
        CHECK_EQ(w->threads.best, 4);
        CHECK(make_steps(w, 2000, busy, 0) < 1.15*2000*busy(1));    /* some 15 steps until it knows */
        CHECK_EQ(w->threads.best, 1);
        make_steps(w, 60000, quiet, 0);
        CHECK_EQ(w->threads.best, 4);
        dem_world_destroy(w);
    }

    TEST("number of threads: the number of threads changes while a world runs, and the bits do not; the report says how many are in use") {
        uint64_t hash[2];
        int k, i;
        for (k = 0; k < 2; k++) {
            dem_world *w = world_of(k ? 3 : 1);
            const dem_material m = scene_material(w, 1e6, 0.5, 0.3, 0);
            dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1));
            dem_spheres_fill(w, m, DEM_R(0.002), dem_region_make(box_of(-0.02, -0.02, 0, 0.02, 0.02, 0.05)), 300, 1);
            w->threads.fixed = 1;
            for (i = 0; i < 40; i++) {
                w->threads.now = w->threads.best = k ? 1 + i%3 : 1;
                CHECK_EQ(scene_step(w, 20), DEM_OK);
            }
            hash[k] = dem_world_hash_get(w);
            if (k) {
                FILE *file = fopen("build/tmp/thread_count.txt", "w+");
                char line[200] = "";
                w->threads.best = 2;
                dem_world_report(w, file);
                rewind(file);
                CHECK(fgets(line, sizeof line, file) != 0);
                CHECK(strstr(line, "3 threads (2 in use: more were not faster)") != 0);
                fclose(file);
                remove("build/tmp/thread_count.txt");
            }
            dem_world_destroy(w);
        }
        CHECK_EQ(hash[1], hash[0]);
    }
    TEST("number of threads: a checkpoint that is read leaves the number of threads as it is: always all, or what trials have found") {
        const char *const path = "build/tmp/thread_count.dem";
        int k;
        for (k = 0; k < 2; k++) {
            dem_world *w = world_of(3);
            scene_material(w, 1e6, 0.5, 0.3, 0);
            w->threads.fixed = k;
            make_steps(w, 100, few, 0);
            CHECK_EQ(w->threads.best, k ? 3 : 1);
            CHECK_EQ(dem_checkpoint_write(w, path), DEM_OK);
            CHECK_EQ(dem_checkpoint_read(w, path), DEM_OK);
            CHECK_EQ(w->threads.fixed, k);
            CHECK_EQ(w->threads.best, k ? 3 : 1);
            remove(path);
            dem_world_destroy(w);
        }
    }
    return test_end();
}
