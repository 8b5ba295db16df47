/* Cells of tables: a number that does not exist leaves its cell empty, as readers of tables expect. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("a measure of mixing that does not exist yet is an empty cell of the CSV file, and every line has all cells") {
        static const char *const path = "build/tmp/cells.csv";
        dem_world_desc d = DEM_WORLD_DESC;
        dem_output_desc o = DEM_OUTPUT_DESC;
        dem_material m;
        dem_world *w;
        char line[1000];
        int i, grains, lines = 0, columns = 0;
        FILE *file;
        for (grains = 0; grains < 3; grains++) {        /* none, one (nothing to compare), two */
            remove(path);
            d.dt = DEM_R(1e-6);
            w = dem_world_create(&d);
            m = scene_material(w, 5e6, 0.5, 0.3, 0);
            for (i = 0; i < grains; i++) dem_sphere_add(w, m, DEM_R(1e-3), at(0.003 + 0.003*i, 0.003, 0.003));
            o.kind = DEM_OUTPUT_CSV; o.path = path; o.interval = 1e-6;
            o.mixing.box = box_of(0, 0, 0, 0.01, 0.01, 0.01);
            o.mixing.cells[0] = o.mixing.cells[1] = o.mixing.cells[2] = 2;
            o.mixing.material = m;
            CHECK(dem_output_add(w, &o).id > 0);
            CHECK_EQ(dem_world_step(w, 2), DEM_OK);
            file = fopen(path, "r");
            CHECK(file != 0);
            for (lines = 0; file && fgets(line, sizeof line, file); lines++) {
                int commas = 0;
                for (i = 0; line[i]; i++) commas += line[i] == ',';
                if (!lines) columns = commas;
                CHECK_EQ(commas, columns);
                if (lines) CHECK(!strstr(line, "nan") && !strstr(line, "inf") && strstr(line, ",,"));
            }
            if (file) fclose(file);
            CHECK(lines > 2);
            dem_world_destroy(w);
        }
        remove(path);
    }
    return test_end();
}
