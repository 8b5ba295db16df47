/* Overlaps above 0.05 R: the report and the progress line name them, desc.overlap_stop ends the run. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

enum { SHAPES = 4, PARTNERS = 4 };             /* sphere, ellipsoid, cluster, box; plane, mesh, cylinder, a fixed sphere */
/* A body of half height 0.01 m that overlaps its partner by 0.3 of that. */
static dem_world *overlaps_world(int shape, int partner, int impulses, double stop) {
    static const double mesh_x[] = {-1, -1, 0, 1, -1, 0, 0, 1, 0};
    static const double two[] = {-0.002, 0, 0, 0.002, 0, 0};
    dem_real corners[9], balls[6];
    int32_t triangle[3] = {0, 1, 2};
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = DEM_MATERIAL_DESC;
    dem_cluster_desc cluster = DEM_CLUSTER_DESC;
    dem_mesh mesh;
    dem_shape s = {0};
    dem_material m;
    dem_world *w;
    int i;
    desc.overlap_stop = (dem_real)stop;
    desc.response = impulses ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS;
    desc.dt = impulses ? DEM_R(1e-4) : 0;
    stuff.density = 2500; stuff.young = DEM_R(1e6); stuff.poisson = DEM_R(0.3); stuff.restitution = DEM_R(0.5);
    w = dem_world_create(&desc);
    m = dem_material_add(w, &stuff);
    for (i = 0; i < 9; i++) corners[i] = (dem_real)mesh_x[i];
    for (i = 0; i < 6; i++) balls[i] = (dem_real)two[i];
    mesh.vertex_count = 3; mesh.triangle_count = 1; mesh.vertices = corners; mesh.triangles = triangle;
    if (partner == 0) dem_wall_plane_add(w, m, at(0, 0, 0), at(0, 0, 1));
    if (partner == 1) dem_wall_mesh_add(w, m, &mesh);
    if (partner == 2) dem_wall_cylinder_add(w, m, at(0, 0, 0.5), at(0, 1, 0), DEM_R(0.5), 1);
    if (shape == 1) s = dem_shape_ellipsoid_add(w, at(0.012, 0.01, 0.01));
    if (shape == 2) {
        cluster.count = 2; cluster.positions = balls; cluster.radius = DEM_R(0.01);
        s = dem_shape_cluster_add(w, &cluster);
    }
    if (shape == 3) s = scene_box(w, 0.02, 0.02, 0.02);
    if (shape) dem_body_add(w, m, s, at(0.0005, 0.0003, 0.007), dem_quat_make(1, 0, 0, 0));
    else dem_sphere_add(w, m, DEM_R(0.01), at(0.0005, 0.0003, 0.007));
    if (partner == 3) {
        const dem_body ball = dem_sphere_add(w, m, DEM_R(0.05), at(0.0005, 0.0003, -0.05));
        dem_body_state state;
        dem_body_get(w, ball, &state);
        state.fixed = 1;
        dem_body_set(w, ball, &state);
    }
    return w;
}
/* Counts in what report and progress line print of a world the two lines that end with `where`. */
static int overlaps_named(dem_world *w, const char *where) {
    char line[400];
    int n = 0;
    FILE *f = tmpfile();
    if (!f) return -1;
    dem_progress_print(w, 1, 0, f);
    dem_world_report(w, f);
    rewind(f);
    while (fgets(line, sizeof line, f)) n += strstr(line, "overlap ") && strstr(line, where);
    fclose(f);
    return n;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("report and progress line name an overlap above 0.05, and overlap_stop ends the run") {
        int shape, partner, impulses;
        for (shape = 0; shape < SHAPES; shape++)
            for (partner = 0; partner < PARTNERS; partner++)
                for (impulses = 0; impulses < 2; impulses++) {
                    const char *where = partner < 3 ? "since t = 0 s, body 1, wall 1: jammed or too soft"
                                                    : "since t = 0 s, body 1, body 2: jammed or too soft";
                    dem_world *w = overlaps_world(shape, partner, impulses, 0);
                    dem_result result = dem_world_step(w, 1);
                    int named = overlaps_named(w, where), again;
                    dem_overlap_max_reset(w);
                    again = overlaps_named(w, "jammed");
                    if (result != DEM_OK || named != 2 || again)
                        printf("        shape %d, partner %d, impulses %d: named %d, after a reset %d, %s\n", shape, partner,
                               impulses, named, again, dem_world_error_get(w));
                    CHECK_EQ(result, DEM_OK);
                    CHECK_EQ(named, 2);
                    CHECK_EQ(again, 0);
                    dem_world_destroy(w);
                    w = overlaps_world(shape, partner, impulses, 0.02);
                    CHECK_EQ(dem_world_step(w, 5), DEM_ERROR_STOPPED);
                    CHECK_EQ(dem_world_steps_get(w), 1);
                    CHECK(strstr(dem_world_error_get(w), partner < 3 ? "body 1 overlaps wall 1" : "body 1 overlaps body 2"));
                    dem_world_destroy(w);
                    w = overlaps_world(shape, partner, impulses, 0.6);
                    CHECK_EQ(dem_world_step(w, 5), DEM_OK);
                    dem_world_destroy(w);
                }
    }
    TEST("slabs stop at the same step and name the same contact as one world") {
        dem_world *w = overlaps_world(0, 0, 0, 0.1), *one = overlaps_world(0, 0, 0, 0.1);
        dem_slabs_desc desc = DEM_SLABS_DESC;
        dem_material m = {1};
        dem_slabs *s;
        desc.count = 2;
        dem_sphere_add(w, m, DEM_R(0.01), at(0.3, 0, 0.1));
        dem_sphere_add(one, m, DEM_R(0.01), at(0.3, 0, 0.1));
        s = dem_slabs_create(w, &desc);
        CHECK(s != 0);
        CHECK_EQ(dem_slabs_step(s, 5), DEM_ERROR_STOPPED);
        CHECK_EQ(dem_slabs_collect(s, w), DEM_OK);
        CHECK_EQ(dem_world_step(one, 5), DEM_ERROR_STOPPED);
        CHECK_EQ(dem_world_steps_get(w), dem_world_steps_get(one));
        CHECK(!memcmp(&w->booked.crushed, &one->booked.crushed, sizeof one->booked.crushed));
        dem_slabs_destroy(s);
        dem_world_destroy(w);
        dem_world_destroy(one);
    }
    TEST("dem_world_check warns of a predicted overlap above 0.05, and its modulus is enough") {
        static const double speeds[] = {0.6, 1, 3, 9};
        int i, law, again;
        for (i = 0; i < 4; i++)
            for (law = 0; law < 2; law++) {
                double young = 1e6;
                for (again = 0; again < 2; again++) {
                    dem_world_desc desc = DEM_WORLD_DESC;
                    dem_material_desc stuff = DEM_MATERIAL_DESC;
                    dem_finding f[8];
                    dem_world *w;
                    const char *at_modulus;
                    int k, found = 0, n;
                    desc.normal_law = law ? DEM_NORMAL_LINEAR : DEM_NORMAL_HERTZ;
                    desc.impact_speed = (dem_real)speeds[i];
                    stuff.density = 2500; stuff.young = (dem_real)young; stuff.restitution = DEM_R(0.5);
                    w = dem_world_create(&desc);
                    dem_sphere_add(w, dem_material_add(w, &stuff), DEM_R(2e-3), at(0, 0, 0));
                    n = dem_world_check(w, f, 8);
                    for (k = 0; k < n && k < 8; k++) {
                        if (!strstr(f[k].text, "will overlap")) continue;
                        found++;
                        CHECK_EQ(f[k].severity, DEM_SEVERITY_WARNING);
                        CHECK(strstr(f[k].text, "keep it below 0.05"));
                        at_modulus = strstr(f[k].text, "modulus of ");
                        if (at_modulus) young = atof(at_modulus + 11);
                    }
                    CHECK_EQ(found, !again);    /* 1 MPa is too soft at 0.6 m/s: 0.11 of the radius */
                    dem_world_destroy(w);
                }
            }
    }
    TEST("dem_world_check asks for no modulus where impulses need none") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_material_desc stuff = DEM_MATERIAL_DESC;
        dem_finding f[8];
        dem_world *w;
        int k, n;
        desc.response = DEM_RESPONSE_IMPULSES; desc.dt = DEM_R(1e-3);
        stuff.density = 2500;
        w = dem_world_create(&desc);
        dem_sphere_add(w, dem_material_add(w, &stuff), DEM_R(2e-3), at(0, 0, 0));
        n = dem_world_check(w, f, 8);
        for (k = 0; k < n && k < 8; k++) CHECK(!strstr(f[k].text, "modulus"));
        dem_world_destroy(w);
    }
    TEST("dem_world_check warns of a user-defined law that ignores rolling or spinning friction") {
        int law, of;
        for (law = 0; law < 2; law++)
            for (of = 0; of < 3; of++) {
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_material_desc stuff = DEM_MATERIAL_DESC;
                dem_pair pair;
                dem_finding f[8];
                dem_material m;
                dem_world *w;
                int k, n, found = 0;
                if (law) { desc.law = dem_law_hertz; desc.law_memory = 0; }
                stuff.density = 2500; stuff.young = DEM_R(1e8); stuff.restitution = DEM_R(0.5); stuff.friction = DEM_R(0.5);
                if (of == 1) stuff.rolling_friction = DEM_R(0.1);
                w = dem_world_create(&desc);
                m = dem_material_add(w, &stuff);
                if (of == 2) {
                    CHECK_EQ(dem_pair_get(w, m, m, &pair), DEM_OK);
                    pair.spinning_friction = DEM_R(0.1);
                    CHECK_EQ(dem_pair_set(w, m, m, &pair), DEM_OK);
                }
                dem_sphere_add(w, m, DEM_R(2e-3), at(0, 0, 0));
                n = dem_world_check(w, f, 8);
                for (k = 0; k < n && k < 8; k++) found += strstr(f[k].text, "desc.law exerts no moment") != 0;
                CHECK_EQ(found, law && of);
                dem_world_destroy(w);
            }
    }
    return test_end();
}
