/* Text is the same in every locale. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"
#include <locale.h>
#if !defined(_WIN32) && !defined(__cplusplus)
extern int setenv(const char *name, const char *value, int replace);    /* POSIX, hidden by -std=c99 */
#endif

/* Sets the first locale with a decimal comma, and makes one if there is none. 0: it cannot be made. */
static int comma(void) {
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8", "German_Germany.1252"};
    int i, made;
    for (made = 0; made < 2; made++) {
        for (i = 0; i < 5; i++) if (setlocale(LC_NUMERIC, names[i]) && localeconv()->decimal_point[0] == ',') return 1;
#ifndef _WIN32
        if (system("mkdir -p build/tmp/locale && localedef -i de_DE -f UTF-8 build/tmp/locale/de_DE.UTF-8 2>/dev/null") ||
            setenv("LOCPATH", "build/tmp/locale", 1)) return 0;
#endif
    }
    return 0;
}
/* Writes all that dem.h prints about a scene into `text`. */
static void printed(dem_world *world, char *text, size_t room) {
    FILE *f = tmpfile();
    const dem_vec3 bad = dem_vec3_make(DEM_R(1.5), 0, 0);
    const dem_material first = {1};
    CHECK(f != 0);
    if (!f) return;
    dem_world_report(world, f);
    dem_pairs_print(world, f);
    dem_world_check_print(world, f);
    dem_progress_print(world, dem_world_time_get(world), 1, f);
    dem_sphere_add(world, first, DEM_R(-0.25), bad);
    fprintf(f, "%s\n", dem_world_error_get(world));
    rewind(f);
    text[fread(text, 1, room - 1, f)] = 0;
    fclose(f);
}

int main(int argc, char **argv) {
    static char point[60000], mark[60000];
    char text[200];
    dem_world_desc desc = DEM_WORLD_DESC;
    test_begin(argc, argv);
    TEST("text is that of printf: lengths, widths, precisions, stars, percent signs and truncation") {
        static char wanted[200];
        const double values[] = {0, 1, -1.5, 1e-300, 1.0/3, 123456789.125, -1e300};
        int k, n;
        for (k = 0; k < 7; k++) {
            snprintf(wanted, sizeof wanted, "%g|%.3g|%10.2e|%-9.4g|%.*g|%5.1f%%", values[k], values[k], values[k], values[k],
                     3, values[k], k < 6 ? values[k] : 0);
            demi_words(text, sizeof text, "%g|%.3g|%10.2e|%-9.4g|%.*g|%5.1f%%", values[k], values[k], values[k], values[k],
                       3, values[k], k < 6 ? values[k] : 0);
            CHECK(!strcmp(text, wanted));
        }
        snprintf(wanted, sizeof wanted, "%d %-4d| %03u %llu %ld %lu %x %c %.*s %-6s| %zu %lld", -3, 7, 5u, 1ull << 60, -9L, 8ul,
                 255u, 'q', 2, "abc", "de", (size_t)77, -5ll);
        n = demi_words(text, sizeof text, "%d %-4d| %03u %llu %ld %lu %x %c %.*s %-6s| %zu %lld", -3, 7, 5u, 1ull << 60, -9L,
                       8ul, 255u, 'q', 2, "abc", "de", (size_t)77, -5ll);
        CHECK(!strcmp(text, wanted));
        CHECK_EQ(n, (int)strlen(wanted));
        n = demi_words(text, 6, "%s %d", "abcd", 123);
        CHECK_EQ(n, 8);
        CHECK(!strcmp(text, "abcd "));
        CHECK(demi_words(text, sizeof text, "%g", HUGE_VAL) == 3 && !strcmp(text, "inf"));
    }
    TEST("reports, progress lines and error messages have a decimal point in a locale with a decimal comma") {
        dem_world *world;
        desc.threads = 1;
        desc.ledger = 1;
        desc.gravity.z = DEM_R(-9.81);
        world = dem_world_create(&desc);
        dem_material_desc stuff = scene_stuff(1e6, 0.5, 0.3, 0.1);
        const dem_material m = dem_material_add(world, &stuff);
        dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        dem_sphere_add(world, m, DEM_R(1.25e-3), at(0, 0, 1.2e-3));
        CHECK_EQ(scene_step(world, 20), DEM_OK);
        printed(world, point, sizeof point);
        CHECK_STR(point, "-0.25");
        if (comma()) {
            demi_words(text, sizeof text, "%.2f %8.3g %e", 0.25, -1.5, 2.5);
            printed(world, mark, sizeof mark);
            setlocale(LC_NUMERIC, "C");
            CHECK_STR(text, "0.25     -1.5 2.500000e+00");
            CHECK(!strcmp(point, mark));
        } else printf("SKIP: no locale with a decimal comma (Debian package locales: localedef -i de_DE -f UTF-8 de_DE.UTF-8)\n");
        dem_world_destroy(world);
    }
    return test_end();
}
