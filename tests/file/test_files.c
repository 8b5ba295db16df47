/* test_files.c - meshes and profiles in; VTP, VTK, XYZ and CSV out. Files go to build/tmp/. What VTK and
   ASE make of the files is another matter: make readers. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"
#include <locale.h>

static dem_world *world_make(scene_memory *p) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.dt = DEM_R(1e-5);
    desc.threads = 1;
    if (p) scene_memory_use(p, &desc);
    return dem_world_create(&desc);
}

static dem_material material_make(dem_world *world) {
    dem_material_desc desc = DEM_MATERIAL_DESC;
    desc.density = 2500;
    desc.young = DEM_R(1e7);
    desc.poisson = DEM_R(0.25);
    desc.restitution = DEM_R(0.5);
    return dem_material_add(world, &desc);
}

/* Three grains of two materials and known radii. */
static dem_world *three_make(scene_memory *p) {
    dem_world *world = world_make(p);
    dem_material first = material_make(world), second = material_make(world);
    dem_body body = dem_sphere_add(world, first, DEM_R(0.125), dem_vec3_make(1, 2, 3));
    dem_body_state state;
    dem_sphere_add(world, second, DEM_R(0.25), dem_vec3_make(-1, 0, DEM_R(0.5)));
    dem_sphere_add(world, second, DEM_R(0.5), dem_vec3_make(10, 20, -30));
    dem_body_get(world, body, &state);
    state.velocity = dem_vec3_make(4, 5, DEM_R(-0.75));
    state.spin = dem_vec3_make(7, 8, 9);
    dem_body_set(world, body, &state);
    return world;
}

static const char box_text[] = /* [MIL] Fig 5.12 */
    "8 12\n-1 -1 -1\n-1 -1 1\n-1 1 -1\n-1 1 1\n1 -1 -1\n1 -1 1\n1 1 -1\n1 1 1\n"
    "1 2 3\n2 3 4\n1 2 5\n2 5 6\n1 3 5\n3 5 7\n5 6 7\n6 7 8\n3 4 7\n4 7 8\n2 4 6\n4 6 8\n";
static const char box_obj[] = "# a cube\nmtllib none.mtl\no cube\nv -1 -1 -1\nv 1 -1 -1\nv 1 1 -1 0.5 0.5 0.5\n"
    "v -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1 1\nv -1 1 1\nvt 0 0\nvn 0 0 1\ns off\n"
    "f 4 3 2 1\nf -4 -3 -2 -1\nf 1/1 2/1 6/1 5/1\nf 2//1 3//1 7//1 6//1\nf 3/1/1 4/1/1 8/1/1 7/1/1\nf 4 1 5 8\n";
static const char profile_text[] = "4 3\n-1 1\n-1 -1\n1 -1\n1 1.5e0\n1 2\n2 3\n3 4\n";

static dem_result parse(dem_world *world, const char *text, dem_mesh *mesh, dem_mesh_health *health) {
    return dem_mesh_parse(world, "some.mesh", text, strlen(text), mesh, health);
}

static int mesh_is_empty(const dem_mesh *mesh) {
    return !mesh->vertices && !mesh->triangles && mesh->vertex_count == 0 && mesh->triangle_count == 0;
}

/* Writes the triangles of a mesh as STL, as text or binary; returns the size. */
static size_t stl_text_make(char *out, const dem_mesh *mesh) {
    size_t n = (size_t)sprintf(out, "solid box\n");
    for (int i = 0; i < mesh->triangle_count; i++) {
        n += (size_t)sprintf(out + n, "  facet normal 0 0 0\n    outer loop\n");
        for (int k = 0; k < 3; k++) {
            const dem_real *v = mesh->vertices + 3*mesh->triangles[3*i + k];
            n += (size_t)sprintf(out + n, "      vertex %.9g %.9g %.9g\n", (double)v[0], (double)v[1], (double)v[2]);
        }
        n += (size_t)sprintf(out + n, "    endloop\n  endfacet\n");
    }
    return n + (size_t)sprintf(out + n, "endsolid box\n");
}
static size_t stl_binary_make(unsigned char *out, const dem_mesh *mesh, const char *title) {
    memset(out, 0, 84 + 50*(size_t)mesh->triangle_count);
    memcpy(out, title, strlen(title));
    out[80] = (unsigned char)mesh->triangle_count;
    for (int i = 0; i < mesh->triangle_count; i++)
        for (int k = 0; k < 9; k++) {
            const float value = (float)mesh->vertices[3*mesh->triangles[3*i + k/3] + k%3];
            uint32_t bits;
            memcpy(&bits, &value, 4);
            for (int b = 0; b < 4; b++) out[84 + 50*i + 12 + 4*k + b] = (unsigned char)(bits >> 8*b);
        }
    return 84 + 50*(size_t)mesh->triangle_count;
}

static void file_put(const char *path, const void *data, size_t size) {
    FILE *file = fopen(path, "wb");
    if (!file) return;
    fwrite(data, 1, size, file);
    fclose(file);
}
/* The whole file, with a zero after it; null when there is none. Free it. */
static char *file_get(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    char *data = (char *)malloc(1 << 20);
    *size = 0;
    if (file && data) *size = fread(data, 1, (1 << 20) - 1, file);
    if (data) data[*size] = 0;
    if (file) fclose(file);
    if (file && data) return data;
    free(data);
    return 0;
}
static int file_is_there(const char *path) {
    FILE *file = fopen(path, "rb");
    if (file) fclose(file);
    return file != 0;
}

/* Is there no file whose name begins with this one's and a dot? Without a shell: yes. */
static int nothing_beside(const char *path) {
    char command[200];
    snprintf(command, sizeof command, "ls %s.* > build/tmp/beside 2> build/tmp/beside.err", path);
    return system(command) != 0;
}

/* What a writer does to a world, for tests that go through all of them. */
typedef dem_result (*writer_fn)(dem_world *world, const char *path);
static dem_result walls_write(dem_world *world, const char *path) {
    return dem_walls_vtp_write(world, path, -1, 1);
}
static const writer_fn writers[4] = {dem_vtp_write, dem_vtk_write, dem_xyz_write, walls_write};
static const char *const writer_names[4] = {"dem_vtp_write", "dem_vtk_write", "dem_xyz_write", "dem_walls_vtp_write"};

static void meshes(void) {
    dem_world *world = world_make(0);
    dem_mesh mesh;
    dem_mesh_health health;
    static char text[20000];
    static unsigned char bytes[2000];

    TEST("the box of [MIL] Fig 5.12 reads as closed and healthy") {
        CHECK_EQ(parse(world, box_text, &mesh, &health), DEM_OK);
        CHECK_EQ(mesh.vertex_count, 8);
        CHECK_EQ(mesh.triangle_count, 12);
        CHECK_EQ(mesh.triangles[0], 0);
        CHECK_EQ(mesh.triangles[35], 7);
        CHECK_NEAR(mesh.vertices[5], 1, 0);
        CHECK_EQ(health.open_edges + health.crowded_edges + health.duplicates + health.slivers, 0);
        CHECK_EQ(health.merged_vertices, 0);
        CHECK_NEAR(health.box.lo.x, -1, 0);
        CHECK_NEAR(health.box.hi.z, 1, 0);
        CHECK_STR(health.hint, "");
        dem_mesh_free(world, &mesh);
        CHECK(mesh_is_empty(&mesh));
    }
    TEST("line ends of three systems, a byte order mark, comments and empty lines change nothing") {
        const char *same[] = {"3 1\n0 0 0\n1 0 0\n0 1 0\n1 2 3", "3 1\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n1 2 3\r\n",
            "3 1\r0 0 0\r1 0 0\r0 1 0\r1 2 3\r", "\357\273\2773 1\n0 0 0\n1 0 0\n0 1 0\n1 2 3\n",
            "# a triangle\n\n 3\t1 # counts\n\n0 0 0\n1.0 .0 0.\n+0e5 1E0 -0\n\n  1 2 3\n\n\n"};
        for (int i = 0; i < 5; i++) {
            CHECK_EQ(parse(world, same[i], &mesh, 0), DEM_OK);
            CHECK_EQ(mesh.vertex_count, 3);
            CHECK_EQ(mesh.triangle_count, 1);
            if (mesh.vertices) CHECK(mesh.vertices[3] == 1 && mesh.vertices[7] == 1 && mesh.vertices[8] == 0);
            dem_mesh_free(world, &mesh);
        }
    }
    TEST("text and binary STL give the mesh they were made of, with coincident corners merged") {
        dem_mesh box;
        parse(world, box_text, &box, 0);
        for (int form = 0; form < 3; form++) { /* text; binary; binary that claims to be text */
            size_t size = form ? stl_binary_make(bytes, &box, form == 1 ? "made by hand" : "solid box\nfacet")
                               : stl_text_make(text, &box);
            CHECK_EQ(dem_mesh_parse(world, "box.stl", form ? (const char *)bytes : text, size, &mesh, &health), DEM_OK);
            CHECK_EQ(mesh.vertex_count, 8);
            CHECK_EQ(mesh.triangle_count, 12);
            CHECK_EQ(health.merged_vertices, 28);
            CHECK_EQ(health.open_edges + health.crowded_edges + health.duplicates + health.slivers, 0);
            for (int i = 0; i < 36 && mesh.triangles; i++)
                for (int k = 0; k < 3; k++)
                    CHECK_NEAR(mesh.vertices[3*mesh.triangles[i] + k], box.vertices[3*box.triangles[i] + k], 0);
            dem_mesh_free(world, &mesh);
        }
        dem_mesh_free(world, &box);
    }
    TEST("convex OBJ faces become fans, with texture indices and negative indices allowed") {
        CHECK_EQ(parse(world, box_obj, &mesh, &health), DEM_OK);
        CHECK_EQ(mesh.vertex_count, 8);
        CHECK_EQ(mesh.triangle_count, 12);
        CHECK_EQ(health.open_edges + health.crowded_edges + health.duplicates + health.slivers, 0);
        const int32_t expected[6] = {4, 5, 6, 4, 6, 7}; /* f -4 -3 -2 -1 */
        for (int i = 0; i < 6 && mesh.triangles; i++) CHECK_EQ(mesh.triangles[6 + i], expected[i]);
        dem_mesh_free(world, &mesh);
    }
    TEST("non-convex faces become triangles that cover them once with the same winding") {
        static const struct { const char *face; double area; int split, bent, crossed; } faces[] = {
            {"v 0 0 0\nv 4 0 0\nv 4 2 0\nv 2 .5 0\nv 0 2 0\nf 2 3 4 5 1\n", 5, 1, 0, 0},            /* a notch */
            {"v 0 0 0\nv 3 0 0\nv 3 1 0\nv 1 1 0\nv 1 3 0\nv 0 3 0\nf 3 4 5 6 1 2\n", 5, 1, 0, 0},   /* an L */
            {"v 0 0 0\nv 3 0 0\nv 3 1 0\nv 1 1 0\nv 1 3 0\nv 0 3 0\nf -1 -2 -3 -4 -5 -6\n", -5, 1, 0, 0},
            {"v 0 0 0\nv 1 0 0\nv 2 0 0\nv 2 2 0\nv 1 2 0\nv 0 2 0\nv 0 1 0\nf 1 2 3 4 5 6 7\n", 4, 1, 0, 0},   /* on lines */
            {"v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 2 3 4 4\n", 4, 1, 0, 0},                    /* corners twice */
            {"v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 0\nv 1 3 0\nv 3 3 0\nv 3 1 0\n"
             "f 1 2 3 4 1 5 6 7 8 5\n", 12, 1, 0, 0},                                               /* a hole, bridged */
            {"v 0 0 0\nv 4e-9 0 0\nv 4e-9 2e-9 0\nv 2e-9 .5e-9 0\nv 0 2e-9 0\nf 2 3 4 5 1\n", 5e-18, 1, 0, 0},
            {"v 9000 0 0\nv 9004 0 0\nv 9004 2 0\nv 9002 .5 0\nv 9000 2 0\nf 2 3 4 5 1\n", 5, 1, 0, 0},
            {"v 0 0 0\nv 2 0 0\nv 2 2 .1\nv 0 2 0\nf 1 2 3 4\n", 4, 1, 1, 0},                       /* not flat */
            {"v 0 0 0\nv 4 3 0\nv 4 0 0\nv 0 1 0\nf 1 2 3 4\n", 0, 1, 0, 1},                        /* a bow tie */
            {"v 0 1 0\nv -.6 -.8 0\nv .95 .3 0\nv -.95 .3 0\nv .6 -.8 0\nf 1 2 3 4 5\n", 0, 1, 0, 1}};   /* a pentagram */
        size_t f;
        for (f = 0; f < sizeof faces/sizeof *faces; f++) {
            double area = 0, all = 0;
            int i;
            CHECK_EQ(parse(world, faces[f].face, &mesh, &health), DEM_OK);
            for (i = 0; i < mesh.triangle_count; i++) {
                const dem_real *a = mesh.vertices + 3*mesh.triangles[3*i], *b = mesh.vertices + 3*mesh.triangles[3*i + 1];
                const dem_real *c = mesh.vertices + 3*mesh.triangles[3*i + 2];
                const double one = (double)(b[0] - a[0])*(double)(c[1] - a[1]) - (double)(b[1] - a[1])*(double)(c[0] - a[0]);
                area += one/2;
                all += fabs(one)/2;
            }
            /* sums of a few products; at 9000 m single precision resolves 1e-3 m */
            if (!faces[f].crossed) {
                CHECK_REL(area, faces[f].area, sizeof(dem_real) == 8 ? 1e-11 : 1e-3);
                CHECK_REL(all, fabs(area), 1e-12);
            }
            CHECK_EQ(health.split_faces, faces[f].split);
            CHECK_EQ(health.bent_faces, faces[f].bent);
            CHECK_EQ(health.crossed_faces, faces[f].crossed);
            dem_mesh_free(world, &mesh);
        }
    }
    TEST("a backslash that continues a face hides the next line, whatever it is") {
        CHECK_EQ(parse(world, "v 0 0 0\nv 1 0 0 \\\nv 0 1 0\nf 1 2 3 \\\nv 9 9 9\n", &mesh, &health), DEM_ERROR_FORMAT);
        CHECK_EQ(parse(world, "v 0 0 0\nv 1 0 \\\nv 0 1 0\nf 1 2 3\n", &mesh, &health), DEM_ERROR_FORMAT);
        CHECK_EQ(parse(world, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 \\\n3\n", &mesh, &health), DEM_OK);
        CHECK_EQ(mesh.triangle_count, 1);
        dem_mesh_free(world, &mesh);
    }
    TEST("random inclined faces become triangles of the same area and winding") {
        uint64_t random = 7;
        int trial, i;
        for (trial = 0; trial < 300; trial++) {
            static char face[8000];
            double x[64], y[64], area = 0, sum = 0, least = 0;
            const double a = 3*scene_random(&random), b = 3*scene_random(&random);
            const int corners = 4 + (int)(60*scene_random(&random));
            size_t n = 0;
            for (i = 0; i < corners; i++) {         /* seen from one point inside, each at its angle: a star */
                const double angle = 2*3.14159265358979*(i + 0.4*scene_random(&random))/corners, r = 0.2 + scene_random(&random);
                x[i] = r*cos(angle);
                y[i] = r*sin(angle);
                n += (size_t)sprintf(face + n, "v %.17g %.17g %.17g\n", x[i], y[i], a*x[i] + b*y[i]);
            }
            n += (size_t)sprintf(face + n, "f");
            for (i = 0; i < corners; i++) {
                const int j = (i + 1)%corners;
                area += (x[i]*y[j] - x[j]*y[i])/2;
                n += (size_t)sprintf(face + n, " %d", i + 1);
            }
            CHECK_EQ(parse(world, face, &mesh, &health), DEM_OK);
            CHECK_EQ(mesh.triangle_count, corners - 2);
            CHECK_EQ(health.crossed_faces + health.bent_faces, 0);
            for (i = 0; i < mesh.triangle_count; i++) {
                const dem_real *p = mesh.vertices + 3*mesh.triangles[3*i], *q = mesh.vertices + 3*mesh.triangles[3*i + 1];
                const dem_real *r = mesh.vertices + 3*mesh.triangles[3*i + 2];
                const double one = ((double)q[0] - (double)p[0])*((double)r[1] - (double)p[1]) -
                    ((double)q[1] - (double)p[1])*((double)r[0] - (double)p[0]);
                sum += one/2;
                if (one < least) least = one;
            }
            CHECK_NEAR(sum, area, sizeof(dem_real) == 8 ? 1e-13 : 1e-5);     /* round-off of some 60 terms */
            CHECK_NEAR(least, 0, sizeof(dem_real) == 8 ? 1e-9 : 1e-6);       /* an ear of no area: 1e-10 of the size squared */
            dem_mesh_free(world, &mesh);
        }
    }
    TEST("a face of 2000 comb teeth keeps its area; a larger one is rejected with the limit named") {
        enum { TEETH = 2000, MORE = 5000 };
        static char comb[40*2*MORE + 8*2*MORE + 200];
        int teeth, i;
        for (teeth = TEETH; teeth <= MORE; teeth += MORE - TEETH) {
            size_t n = 0;
            double area = 0;
            for (i = 0; i < teeth; i++)             /* tips at y = 2 over gaps at y = 1, in a plane that leans */
                n += (size_t)sprintf(comb + n, "v %d 2 %d\nv %g 1 %g\n", i, i, i + 0.5, i + 0.5);
            n += (size_t)sprintf(comb + n, "v %d 0 %d\nv 0 0 0\nf", teeth, teeth);
            for (i = 2*teeth + 2; i > 0; i--) n += (size_t)sprintf(comb + n, " %d", i);
            CHECK_EQ(parse(world, comb, &mesh, &health), teeth == TEETH ? DEM_OK : DEM_ERROR_FORMAT);
            for (i = 0; i < mesh.triangle_count; i++) {
                const dem_real *a = mesh.vertices + 3*mesh.triangles[3*i], *b = mesh.vertices + 3*mesh.triangles[3*i + 1];
                const dem_real *c = mesh.vertices + 3*mesh.triangles[3*i + 2];
                area += fabs((double)(b[0] - a[0])*(double)(c[1] - a[1]) - (double)(b[1] - a[1])*(double)(c[0] - a[0]))/2;
            }
            /* each tooth .5 wide on either side, from 1 to 2; the last gap runs down to the corner */
            if (teeth == TEETH) CHECK_REL(area, 1.5*(TEETH - 0.5) + 0.25, 1e-10);
            dem_mesh_free(world, &mesh);
        }
        CHECK_STR(dem_world_error_get(world), "a face that is not convex has 10002 corners, must be at most 10000");
    }
    TEST("health counts open and crowded edges, duplicates and slivers, each once") {
        CHECK_EQ(parse(world, "3 1\n0 0 0\n1 0 0\n0 1 0\n1 2 3\n", &mesh, &health), DEM_OK);
        CHECK_EQ(health.open_edges, 3);
        dem_mesh_free(world, &mesh);
        /* three triangles at one edge, one of them twice, turned round */
        CHECK_EQ(parse(world, "5 4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 -1 0\n1 2 3\n2 1 4\n1 2 5\n5 1 2\n", &mesh, &health), DEM_OK);
        CHECK_EQ(health.crowded_edges, 1);
        CHECK_EQ(health.duplicates, 1);
        CHECK_EQ(health.open_edges, 4); /* the doubled triangle shares its other edges with itself */
        CHECK_EQ(health.slivers, 0);
        dem_mesh_free(world, &mesh);
        /* height 0.9e-3 and 1.1e-3 of the longest side, no area, and a corner twice */
        CHECK_EQ(parse(world, "5 4\n0 0 0\n1 0 0\n.5 .9e-3 0\n.5 1.1e-3 0\n2 0 0\n1 2 3\n1 2 4\n1 2 5\n1 1 2\n", &mesh,
                       &health), DEM_OK);
        CHECK_EQ(health.slivers, 3);
        dem_mesh_free(world, &mesh);
    }
    TEST("mesh health hints at millimetres and at a mesh scaled twice") {
        CHECK_EQ(parse(world, "3 1\n0 0 0\n300 0 0\n0 120 0\n1 2 3\n", &mesh, &health), DEM_OK);
        CHECK_STR(health.hint, "largest extent is 300 m: the file may be in millimetres; multiply its vertices by 0.001");
        dem_mesh_free(world, &mesh);
        CHECK_EQ(parse(world, "3 1\n0 0 0\n3e-4 0 0\n0 1e-4 0\n1 2 3\n", &mesh, &health), DEM_OK);
        CHECK_STR(health.hint, "multiply its vertices by 1000");
        dem_mesh_free(world, &mesh);
    }
    TEST("dem_mesh_place scales, rotates and moves a mesh; values that are not finite are rejected and leave it "
         "unchanged") {
        const dem_quat quarter = dem_quat_make((dem_real)sqrt(0.5), 0, 0, (dem_real)sqrt(0.5)), none = dem_quat_make(0, 0, 0, 0);
        CHECK_EQ(parse(world, "3 1\n0 0 0\n300 0 0\n0 120 0\n1 2 3\n", &mesh, &health), DEM_OK);
        CHECK_EQ(dem_mesh_place(world, &mesh, DEM_R(1e-3), quarter, at(1, 2, 3)), DEM_OK);       /* x to y, y to -x */
        CHECK_NEAR(mesh.vertices[0], 1, 0);
        CHECK_NEAR(mesh.vertices[3], 1, 1e-6);
        CHECK_NEAR(mesh.vertices[4], 2.3, 1e-6);
        CHECK_NEAR(mesh.vertices[6], 0.88, 1e-6);
        CHECK_NEAR(mesh.vertices[8], 3, 1e-6);
        CHECK_EQ(dem_mesh_place(world, &mesh, 1, none, at(0, 0, 0)), DEM_OK);
        CHECK_NEAR(mesh.vertices[4], 2.3, 1e-6);
        CHECK_EQ(dem_mesh_place(world, &mesh, 0, quarter, at(0, 0, 0)), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "dem_mesh_place: scale is 0, must be finite and > 0");
        CHECK_EQ(dem_mesh_place(world, &mesh, 1, quarter, at(0, sqrt(-1.0), 0)), DEM_ERROR_ARGUMENT);
        CHECK_EQ(dem_mesh_place(world, 0, 1, quarter, at(0, 0, 0)), DEM_ERROR_ARGUMENT);
        CHECK_EQ(dem_mesh_place(0, &mesh, 1, quarter, at(0, 0, 0)), DEM_ERROR_ARGUMENT);
        CHECK_NEAR(mesh.vertices[4], 2.3, 1e-6);
        dem_mesh_free(world, &mesh);
    }
    TEST("progress written to a file is one line per tenth of each run, without terminal control characters") {
        char line[200];
        int lines = 0, returns = 0;
        FILE *file = fopen("build/tmp/progress.txt", "w+");
        const double done[12] = {0, 0.05, 0.1, 0.11, 0.19, 0.3, 0.55, 0.56, 0.999, 1, 1, 1};
        int k;
        for (k = 0; k < 12; k++) dem_progress_print(world, done[k], 1, file);
        rewind(file);
        while (fgets(line, sizeof line, file)) { lines++; returns += strchr(line, '\r') != 0; }
        fclose(file);
        CHECK_EQ(lines, 5);                      /* at 0.1, 0.3, 0.55, 0.999 and 1 */
        CHECK_EQ(returns, 0);
    }
    TEST("a decimal comma in the locale changes neither reading nor writing") {
        const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8", "German_Germany.1252"};
        for (int i = 0; i < 5 && !setlocale(LC_NUMERIC, names[i]); i++) {}
        CHECK_EQ(parse(world, "3 1\n0 0 0\n1.5 0 0\n0 1e-4 0\n1 2 3\n", &mesh, &health), DEM_OK);
        if (mesh.vertices) CHECK_NEAR(mesh.vertices[3], 1.5, 0);
        dem_mesh_free(world, &mesh);
        CHECK_EQ(parse(world, "3 1\n0 0 0\n1,5 0 0\n0 1e-4 0\n1 2 3\n", &mesh, &health), DEM_ERROR_FORMAT);
        char number[32];
        CHECK_STR(demi_format_real(number, -1.25e-10, 9), "-1.25e-10");
        setlocale(LC_NUMERIC, "C");
        CHECK_STR(demi_format_real(number, -1.25e-10, 9), "-1.25e-10");
    }
    TEST("number parsing is exact to the last bit") {
        CHECK_EQ(parse(world, "3 1\n0.1 0.3333333333333333148 2.2250738585072014e-308\n1 0 0\n0 1 0\n1 2 3\n", &mesh, 0), DEM_OK);
        if (mesh.vertices) CHECK(mesh.vertices[0] == DEM_R(0.1) && mesh.vertices[1] == DEM_R(1.0/3));
        dem_mesh_free(world, &mesh);
    }
    dem_world_destroy(world);
}

static void bad_meshes(void) {
    scene_memory p;
    dem_world *world = world_make(&p);
    const size_t held = p.bytes;
    dem_mesh mesh;
    dem_mesh_health health;

    TEST("a mesh error names call, file, line, finding, limit and remedy") {
        const char *const bad[][2] = {
            {"", "end of the file"},
            {"   \n# nothing\n\n", "end of the file"},
            {"hello\n", "line 1: found 'hello'"},
            {"3\n", "line 1: found the end of the line"},
            {"3 1\n0 0 0\n1 0 0\n0 1 0\n1 2 4\n", "line 5: found '4' where a corner is expected, a whole number from 1 to 3"},
            {"3 1\n0 0 0\n1 0 0\n0 1 0\n0 1 2\n", "line 5: found '0'"},
            {"3 1\n0 0 0\n1 0 0\n0 1 0\n1 2 -3\n", "found '-3'"},
            {"3 1\n0 0 0\n1 0 0\n0 1 0\n1 2 3.0\n", "found '3.0'"},
            {"3 1\n0 0 0\n1 0 0\n0 1 0\n1 2 99999999999\n", "found '99999999999'"},
            {"3 1\n0 0 0\n1 0\n0 1 0\n1 2 3\n", "line 3: found the end of the line where a coordinate"},
            {"3 1\n0 0 0\n1 0 0 0\n0 1 0\n1 2 3\n", "line 3: found '0' where the line should end"},
            {"3 1\n0 0 0\n1 0 nan\n0 1 0\n1 2 3\n", "line 3: found 'nan'"},
            {"3 1\n0 0 0\n1 0 -inf\n0 1 0\n1 2 3\n", "found '-inf'"},
            {"3 1\n0 0 0\n1 0 1e999\n0 1 0\n1 2 3\n", "found '1e999'"},
            {"3 1\n0 0 0\n1 0 0x10\n0 1 0\n1 2 3\n", "found '0x10'"},
            {"3 1\n0 0 0\n1 0 1.2.3\n0 1 0\n1 2 3\n", "found '1.2.3'"},
            {"3 1\n0 0 0\n1 0 \x01\x80\n0 1 0\n1 2 3\n", "found '\?\?'"},
            {"3 1\n0 0 0\n1 0 0\n0 1 0\n1 2 3\n1 2 3\n", "line 6: found '1' where the file should end"},
            {"3 2\n0 0 0\n1 0 0\n0 1 0\n1 2 3\n", "line 5: found the end of the file where a corner"},
            {"3 20\n0 0 0\n1 0 0\n0 1 0\n1 2 3\n", "found counts 3 and 20, but only 24 bytes follow"},
            {"0 1\n1 1 1\n", "found '0'"},
            {"-3 1\n", "found '-3'"},
            {"solid x\nendsolid x\n", "0 triangles"},
            {"solid x\nfacet normal 0 0 1\nvertex 0 0 0\nvertex 1 0 0\nendfacet\nendsolid\n", "line 5: found 'endfacet'"},
            {"solid x\nfacet\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nvertex 1 1 0\nendfacet\nendsolid\n", "line 6"},
            {"solid x\nfacet\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n", "cut short"},
            {"solid x\nvertex 0 0 0\nfacet\n", "line 2: found 'vertex'"},
            {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2\n", "line 5: found the end of the line where a face"},
            {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n", "found '-4'"},
            {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 /3\n", "found '/3'"},
            {"v 0 0 0\nv 1 0 0\nv 0 1\nf 1 2 3\n", "line 3"},
            {"f 1 2 3\n", "0 vertices"},
            {"v 0 0 0\n", "0 triangles"}};
        for (size_t i = 0; i < sizeof bad/sizeof *bad; i++) {
            memset(&mesh, 255, sizeof mesh);
            CHECK_EQ(parse(world, bad[i][0], &mesh, &health), DEM_ERROR_FORMAT);
            CHECK(mesh_is_empty(&mesh));
            CHECK_STR(dem_world_error_get(world), "dem_mesh_parse: some.mesh");
            CHECK_STR(dem_world_error_get(world), bad[i][1]);
            CHECK(strlen(dem_world_error_get(world)) < 400);
            CHECK_EQ(p.bytes, held);
        }
    }
    TEST("a count beyond the size of the file is rejected before any memory is allocated") {
        const char *const lies[] = {"700000000 700000000\n0 0 0\n", "3 500000000\n0 0 0\n1 0 0\n0 1 0\n1 2 3\n"};
        unsigned char binary[84] = {0};
        for (int i = 0; i < 2; i++) {
            const long calls = p.calls;
            CHECK_EQ(parse(world, lies[i], &mesh, &health), DEM_ERROR_FORMAT);
            CHECK_EQ(p.calls, calls);
            CHECK_STR(dem_world_error_get(world), "bytes follow");
        }
        memset(binary + 80, 255, 4);
        CHECK_EQ(dem_mesh_parse(world, "x.stl", binary, 84, &mesh, 0), DEM_ERROR_FORMAT);
        CHECK_STR(dem_world_error_get(world), "a binary STL has 84 bytes and 50 for each triangle");
        binary[80] = binary[81] = binary[82] = binary[83] = 0;
        CHECK_EQ(dem_mesh_parse(world, "x.stl", binary, 84, &mesh, 0), DEM_ERROR_FORMAT);
        CHECK_EQ(p.bytes, held);
    }
    TEST("a binary STL with a coordinate that is NaN is rejected with its byte named") {
        unsigned char bytes[134] = {0};
        bytes[80] = 1;
        bytes[84 + 12 + 4*4 + 2] = 0xC0; bytes[84 + 12 + 4*4 + 3] = 0x7F; /* nan */
        CHECK_EQ(dem_mesh_parse(world, "x.stl", bytes, sizeof bytes, &mesh, 0), DEM_ERROR_FORMAT);
        CHECK_STR(dem_world_error_get(world), "x.stl byte 112");
        bytes[84 + 12 + 4*4 + 2] = 0x80;                                  /* inf */
        CHECK_EQ(dem_mesh_parse(world, "x.stl", bytes, sizeof bytes, &mesh, 0), DEM_ERROR_FORMAT);
        CHECK_EQ(p.bytes, held);
    }
    TEST("every truncation of a valid file neither crashes nor leaks") {
        static char text[20000];
        dem_mesh box;
        int readable = 0;
        parse(world, box_text, &box, 0);
        for (int form = 0; form < 4; form++) {
            const size_t size = form == 0 ? strlen(box_text) : form == 1 ? strlen(box_obj) :
                form == 2 ? stl_text_make(text, &box) : stl_binary_make((unsigned char *)text, &box, "x");
            const char *whole = form == 0 ? box_text : form == 1 ? box_obj : text;
            for (size_t n = 0; n <= size; n++) {
                char *part = (char *)malloc(n + 1); /* its own, for the address sanitizer */
                if (!part) break;
                memcpy(part, whole, n);
                if (dem_mesh_parse(world, "part", part, n, &mesh, &health) == DEM_OK) readable++;
                else CHECK(mesh_is_empty(&mesh));
                dem_mesh_free(world, &mesh);
                free(part);
            }
        }
        dem_mesh_free(world, &box);
        CHECK(readable >= 4);
        CHECK_EQ(p.bytes, held);
    }
    TEST("every failing allocation of a reader gives DEM_ERROR_MEMORY, an empty mesh and no leak") {
        static char text[20000];
        dem_mesh box;
        dem_profile profile;
        parse(world, box_text, &box, 0);
        for (int form = 0; form < 6; form++) {
            const size_t size = form == 0 ? strlen(box_text) : form == 1 ? strlen(box_obj) :
                form == 2 ? stl_text_make(text, &box) : form == 3 ? stl_binary_make((unsigned char *)text, &box, "x") :
                form == 4 ? strlen(profile_text) : strlen(box_text);
            const char *whole = form == 0 || form == 5 ? box_text : form == 1 ? box_obj : form == 4 ? profile_text : text;
            const size_t before = p.bytes;
            dem_result result = DEM_ERROR_MEMORY;
            if (form == 5) file_put("build/tmp/box.txt", box_text, strlen(box_text));
            for (long k = 1; result != DEM_OK && k < 50; k++) {
                p.refuse = p.calls + k;
                if (form == 4) result = dem_profile_parse(world, "x", whole, size, &profile);
                else if (form == 5) result = dem_mesh_read(world, "build/tmp/box.txt", &mesh, &health);
                else result = dem_mesh_parse(world, "x", whole, size, &mesh, &health);
                if (result == DEM_OK) break;
                CHECK_EQ(result, DEM_ERROR_MEMORY);
                CHECK_STR(dem_world_error_get(world), "memory");
                if (form != 4) CHECK(mesh_is_empty(&mesh));
                CHECK_EQ(p.bytes, before);
            }
            p.refuse = 0;
            CHECK_EQ(result, DEM_OK);
            if (form == 4) dem_profile_free(world, &profile);
            else dem_mesh_free(world, &mesh);
            CHECK_EQ(p.bytes, before);
        }
        dem_mesh_free(world, &box);
        remove("build/tmp/box.txt");
    }
    TEST("reading a missing file, a folder or a null name fails with the name") {
        CHECK_EQ(dem_mesh_read(world, "build/tmp/none.stl", &mesh, &health), DEM_ERROR_FILE);
        CHECK_STR(dem_world_error_get(world), "dem_mesh_read: cannot read build/tmp/none.stl: ");
        CHECK_EQ(dem_mesh_read(world, "build/tmp", &mesh, 0), DEM_ERROR_FILE);
        CHECK_EQ(dem_mesh_read(world, 0, &mesh, 0), DEM_ERROR_ARGUMENT);
        CHECK_EQ(dem_mesh_parse(world, "x", 0, 5, &mesh, 0), DEM_ERROR_ARGUMENT);
        CHECK_EQ(dem_mesh_parse(world, "x", "", 0, 0, 0), DEM_ERROR_ARGUMENT);
        CHECK(mesh_is_empty(&mesh));
        dem_mesh_free(world, 0);
        CHECK_EQ(p.bytes, held);
    }
    TEST("a large file is read completely, and its errors name the line") {
        const int n = 20000;
        char *text = (char *)malloc((size_t)n*48);
        size_t size;
        if (!text) continue;
        size = (size_t)sprintf(text, "%d %d\n", n + 2, n);
        for (int i = 0; i < n + 2; i++) size += (size_t)sprintf(text + size, "%d %d 0\n", i/2, i%2);
        for (int i = 0; i < n; i++) size += (size_t)sprintf(text + size, "%d %d %d\n", i + 1, i + 2, i + 3);
        file_put("build/tmp/strip.txt", text, size);
        CHECK_EQ(dem_mesh_read(world, "build/tmp/strip.txt", &mesh, &health), DEM_OK);
        CHECK_EQ(mesh.triangle_count, n);
        CHECK_EQ(health.open_edges, n + 2);
        dem_mesh_free(world, &mesh);
        text[size - 2] = 'x';
        file_put("build/tmp/strip.txt", text, size);
        CHECK_EQ(dem_mesh_read(world, "build/tmp/strip.txt", &mesh, &health), DEM_ERROR_FORMAT);
        CHECK_STR(dem_world_error_get(world), "dem_mesh_read: build/tmp/strip.txt line 40003: found '2000x'");
        remove("build/tmp/strip.txt");
        free(text);
        CHECK_EQ(p.bytes, held);
    }
    dem_world_destroy(world);
    TEST("a world that read meshes frees all its memory") CHECK_EQ(p.bytes, 0);
}

static void profiles(void) {
    scene_memory p;
    dem_world *world = world_make(&p);
    const size_t held = p.bytes;
    dem_profile profile;
    TEST("a profile reads equally from memory and from a file") {
        for (int from_file = 0; from_file < 2; from_file++) {
            file_put("build/tmp/profile.txt", profile_text, strlen(profile_text));
            if (from_file) CHECK_EQ(dem_profile_read(world, "build/tmp/profile.txt", &profile), DEM_OK);
            else CHECK_EQ(dem_profile_parse(world, 0, profile_text, strlen(profile_text), &profile), DEM_OK);
            CHECK_EQ(profile.vertex_count, 4);
            CHECK_EQ(profile.segment_count, 3);
            if (profile.vertices) CHECK_NEAR(profile.vertices[7], 1.5, 0);
            if (profile.segments) CHECK(profile.segments[0] == 0 && profile.segments[5] == 3);
            dem_profile_free(world, &profile);
            CHECK(!profile.vertices && profile.vertex_count == 0);
            CHECK_EQ(p.bytes, held);
        }
        remove("build/tmp/profile.txt");
    }
    TEST("a bad profile is rejected with its line named") {
        const char *const bad[][2] = {{"", "end of the file"}, {"2 1\n0 0\n1 1\n1 3\n", "line 4: found '3'"},
            {"2 1\n0 0\n1 1\n2 2\n", "same corner twice"}, {"2 1\n0 0 0\n1 1 0\n1 2\n", "line 2: found '0'"},
            {"2 1\n0 0\n1 1\n1 2\n1", "line 5"}, {"solid x\n", "found 'solid'"}};
        for (size_t i = 0; i < sizeof bad/sizeof *bad; i++) {
            CHECK_EQ(dem_profile_parse(world, "p.txt", bad[i][0], strlen(bad[i][0]), &profile), DEM_ERROR_FORMAT);
            CHECK_STR(dem_world_error_get(world), "dem_profile_parse: p.txt");
            CHECK_STR(dem_world_error_get(world), bad[i][1]);
            CHECK(!profile.vertices && !profile.segments && profile.vertex_count == 0 && profile.segment_count == 0);
            CHECK_EQ(p.bytes, held);
        }
        CHECK_EQ(dem_profile_read(world, "build/tmp/none.txt", &profile), DEM_ERROR_FILE);
        CHECK_EQ(dem_profile_read(world, 0, &profile), DEM_ERROR_ARGUMENT);
        CHECK_EQ(dem_profile_parse(world, "x", 0, 0, &profile), DEM_ERROR_ARGUMENT);
    }
    dem_world_destroy(world);
}

static void pictures(void) {
    dem_world *world = three_make(0);
    size_t size;

    TEST("a VTP file declares its arrays and holds radii at the declared offset") {
        CHECK_EQ(dem_vtp_write(world, "build/tmp/three.vtp"), DEM_OK);
        char *text = file_get("build/tmp/three.vtp", &size);
        CHECK(text != 0);
        if (!text) continue;
        CHECK_STR(text, "NumberOfPoints=\"3\" NumberOfVerts=\"3\"");
        CHECK_STR(text, sizeof(dem_real) == 4 ? "\"Float32\" Name=\"velocity\" NumberOfComponents=\"3\""
                                              : "\"Float64\" Name=\"velocity\" NumberOfComponents=\"3\"");
        const char *array = strstr(text, "Name=\"radius\""), *data = strstr(text, "<AppendedData encoding=\"raw\">\n_");
        const char *offset = array ? strstr(array, "offset=\"") : 0;
        CHECK(offset && data);
        if (offset && data) {
            uint64_t bytes;
            dem_real radius[3];
            const char *at = data + strlen("<AppendedData encoding=\"raw\">\n_") + atoi(offset + 8);
            memcpy(&bytes, at, sizeof bytes);
            memcpy(radius, at + 8, sizeof radius);
            CHECK_EQ(bytes, sizeof radius);
            CHECK_NEAR(radius[0] + radius[1] + radius[2], 0.875, 0);
        }
        CHECK(size > 20 && memcmp(text + size - 12, "\n</VTKFile>\n", 12) == 0);
        free(text);
    }
    TEST("a legacy VTK file is binary and big-endian") {
        CHECK_EQ(dem_vtk_write(world, "build/tmp/three.vtk"), DEM_OK);
        char *text = file_get("build/tmp/three.vtk", &size);
        CHECK(text != 0);
        if (!text) continue;
        CHECK_STR(text, "# vtk DataFile Version 3.0\n");
        CHECK_STR(text, "BINARY\nDATASET POLYDATA\n");
        const char *end = text + size - 13; /* the materials 1, 2, 2 and a line end */
        const dem_bodies b = dem_bodies_get(world);
        for (int i = 0; i < 3; i++) CHECK_EQ(end[4*i + 3], b.materials[i]);
        free(text);
    }
    TEST("an extended XYZ file has positions, radii, velocities and ids, and the domain as lattice") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_material grain;
        dem_world *box;
        double v[9];
        char species[8];
        CHECK_EQ(dem_xyz_write(world, "build/tmp/three.xyz"), DEM_OK);
        char *text = file_get("build/tmp/three.xyz", &size), *line;
        CHECK(text != 0);
        if (!text) continue;
        CHECK_STR(text, "3\nProperties=species:S:1:pos:R:3:radius:R:1:velo:R:3:id:I:1 Time=0\n");
        line = strstr(text, "\nH ");
        CHECK(line && sscanf(line, "%7s %lf %lf %lf %lf %lf %lf %lf %lf", species, v, v + 1, v + 2, v + 3, v + 4, v + 5,
                             v + 6, v + 7) == 9);
        if (line) CHECK(v[0] == 1 && v[1] == 2 && v[2] == 3 && v[3] == 0.125 && v[4] == 4 && v[5] == 5 && v[6] == -0.75);
        CHECK_STR(text, "\nHe -1 0 0.5 0.25 0 0 0 ");
        free(text);
        desc.domain = dem_box_make(-1, -2, 0, 1, 2, DEM_R(0.5));
        desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
        desc.dt = DEM_R(1e-5);
        box = dem_world_create(&desc);
        grain = material_make(box);
        dem_sphere_add(box, grain, DEM_R(0.1), dem_vec3_make(0, 0, DEM_R(0.25)));
        CHECK_EQ(dem_xyz_write(box, "build/tmp/box.xyz"), DEM_OK);
        text = file_get("build/tmp/box.xyz", &size);
        CHECK_STR(text, "Lattice=\"2 0 0 0 4 0 0 0 0.5\" Origin=\"-1 -2 0\" pbc=\"F T F\" Properties=");
        free(text);
        remove("build/tmp/box.xyz");
        dem_world_destroy(box);
    }
    TEST("a world without grains or walls gives files without points") {
        dem_world *empty = world_make(0);
        for (int i = 0; i < 4; i++) CHECK_EQ(writers[i](empty, "build/tmp/empty.out"), DEM_OK);
        remove("build/tmp/empty.out");
        dem_world_destroy(empty);
    }
    dem_world_destroy(world);
}

/* Turned a quarter about z and moved by 10 along x, for all time. */
static void quarter(double time, dem_pose *pose, void *user) {
    (void)time; (void)user;
    memset(pose, 0, sizeof *pose);
    pose->position.x = 10;
    pose->rotation[1] = -1;
    pose->rotation[3] = pose->rotation[8] = 1;
}

/* Contacts written by a function that a run or dem_contacts_each calls. */
typedef struct contacts_writer { dem_world *world; int calls, failed; } contacts_writer;
static int contacts_during(const dem_world *world, double done, double left, void *user) {
    contacts_writer *by = (contacts_writer *)user;
    (void)world; (void)done; (void)left;
    by->calls++;
    by->failed += dem_contacts_csv_write(by->world, "build/tmp/contacts_during.csv") != DEM_OK;
    by->failed += dem_contacts_vtp_write(by->world, "build/tmp/contacts_during.vtp") != DEM_OK;
    by->failed += dem_vtp_write(by->world, "build/tmp/during.vtp") != DEM_OK;
    by->failed += dem_vtk_write(by->world, "build/tmp/during.vtk") != DEM_OK;
    by->failed += dem_xyz_write(by->world, "build/tmp/during.xyz") != DEM_OK;
    by->failed += dem_surfaces_vtp_write(by->world, "build/tmp/during.vtp") != DEM_OK;
    by->failed += dem_walls_vtp_write(by->world, "build/tmp/during.vtp", 0, 1) != DEM_OK;
    by->failed += dem_bodies_csv_write(by->world, "build/tmp/during.csv") != DEM_OK;
    by->failed += dem_checkpoint_write(by->world, "build/tmp/during.checkpoint") != DEM_OK;
    return 0;
}
static void contacts_within(const dem_contact_info *contact, dem_real *memory, void *user) {
    contacts_writer *by = (contacts_writer *)user;
    (void)contact; (void)memory;
    by->calls++;
    by->failed += dem_contacts_csv_write(by->world, "build/tmp/contacts_within.csv") != DEM_OK;
    by->failed += dem_contacts_vtp_write(by->world, "build/tmp/contacts_within.vtp") != DEM_OK;
}

static int contacts_change(dem_world *world, int64_t number, void *user) {
    dem_body_state state;
    (void)number; (void)user;
    dem_body_get(world, dem_body_id_get(world, 0), &state);
    state.velocity.x += DEM_R(0.01);
    return dem_body_set(world, dem_body_id_get(world, 0), &state) != DEM_OK;
}
static contacts_writer *contacts_late_by;
static void contacts_late(const dem_world *world, double *values, void *user) {
    contacts_writer *by = contacts_late_by;
    (void)world; (void)user;
    values[0] = ++by->calls;
    by->failed += dem_contacts_csv_write(by->world, "build/tmp/contacts_late.csv") != DEM_OK;
    CHECK_STR(dem_world_error_get(by->world), "dem_contacts_csv_write: the scene has changed since the last step");
    by->failed += dem_contacts_vtp_write(by->world, "build/tmp/contacts_late.vtp") != DEM_OK;
}

static void walls(void) {
    dem_world *world = world_make(0);
    dem_material steel = material_make(world);
    dem_mesh mesh;
    dem_profile profile;
    dem_wall plane, moved;
    size_t size;
    parse(world, "3 1\n1 0 0\n0 1 0\n0 0 1\n1 2 3\n", &mesh, 0);
    dem_profile_parse(world, "p", profile_text, strlen(profile_text), &profile);
    plane = dem_wall_plane_add(world, steel, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
    moved = dem_wall_mesh_add(world, steel, &mesh);

    TEST("walls are drawn at their present pose, profiles between z0 and z1, infinite walls not at all") {
        dem_motion motion = DEM_MOTION;
        motion.kind = DEM_MOTION_USER;
        motion.function = quarter;
        CHECK_EQ(dem_wall_motion_set(world, moved, &motion), DEM_OK);
        dem_wall_profile_add(world, steel, &profile, DEM_EDGE_RESOLVED);
        CHECK_EQ(dem_walls_vtp_write(world, "build/tmp/walls.vtp", -2, 2), DEM_OK);
        char *text = file_get("build/tmp/walls.vtp", &size);
        CHECK(text != 0);
        if (!text) continue;
        CHECK_STR(text, "NumberOfPoints=\"11\""); /* 3 + 2 x 4 */
        CHECK_STR(text, "NumberOfPolys=\"7\"");   /* 1 + 2 x 3 */
        const char *data = strstr(text, "<AppendedData encoding=\"raw\">\n_");
        if (data) {
            dem_real p[33];
            int32_t id[7], corner[21];
            data += strlen("<AppendedData encoding=\"raw\">\n_") + 8;
            memcpy(p, data, sizeof p);
            memcpy(id, data + sizeof p + 8, sizeof id);
            memcpy(corner, data + sizeof p + 8 + sizeof id + 8, sizeof corner);
            CHECK(p[0] == 10 && p[1] == 1 && p[2] == 0); /* (1, 0, 0) turned and moved */
            CHECK(p[3] == 9 && p[4] == 0 && p[8] == 1);
            CHECK(p[9] == -1 && p[10] == 1 && p[11] == -2 && p[23] == 2);
            CHECK_EQ(id[0], moved.id);
            CHECK_EQ(id[6], moved.id + 1);
            CHECK(corner[3] == 3 && corner[4] == 4 && corner[5] == 8 && corner[6] == 3 && corner[7] == 8 && corner[8] == 7);
        }
        free(text);
    }
    TEST("bodies are drawn as surfaces, cubes by six faces and balls by facets, with their data at every corner") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_real cube[24], pair[6] = {0, 0, 0, 1, 0, 0}, *numbers;
        dem_cluster_desc cluster = DEM_CLUSTER_DESC;
        dem_material m;
        dem_world *w;
        dem_body b;
        char *data;
        int k, off = 0;
        desc.body_reals = "charge";
        w = dem_world_create(&desc);
        m = scene_material(w, 1e7, 0.5, 0, 0);
        for (k = 0; k < 24; k++) cube[k] = k/3 >> k%3 & 1 ? DEM_R(0.5) : DEM_R(-0.5);
        cluster.count = 2;
        cluster.positions = pair;
        cluster.radius = DEM_R(0.8);
        b = dem_body_add(w, m, dem_shape_polyhedron_add(w, 8, cube), at(3, 0, 0), dem_quat_make(1, 0, 0, 0));
        scene_move(w, b, at(0, 2, 0), at(0, 0, 0));
        dem_body_add(w, m, dem_shape_cluster_add(w, &cluster), at(0, 4, 0), dem_quat_make(1, 0, 0, 0));
        dem_sphere_add(w, m, 1, at(-3, 0, 0));
        CHECK_EQ(dem_surfaces_vtp_write(w, "build/tmp/surfaces.vtp"), DEM_OK);
        data = file_get("build/tmp/surfaces.vtp", &size);
        CHECK(data != 0);
        CHECK_STR(data, "NumberOfPoints=\"350\"");     /* 8 + 3 x 114 */
        CHECK_STR(data, "NumberOfPolys=\"390\"");      /* 6 + 3 x 128 */
        CHECK_STR(data, "Name=\"charge\"");
        numbers = (dem_real *)malloc(350*6*sizeof(dem_real));
        if (data && numbers && strstr(data, "_")) {
            const char *from = strstr(data, "<AppendedData encoding=\"raw\">\n_") + strlen("<AppendedData encoding=\"raw\">\n_") + 8;
            memcpy(numbers, from, 1050*sizeof(dem_real));
            memcpy(numbers + 1050, from + 1050*sizeof(dem_real) + 8, 1050*sizeof(dem_real));
            for (k = 0; k < 8; k++)             /* its corners, and how fast they are */
                off += !(fabs((double)numbers[3*k] - 3) == 0.5 && fabs((double)numbers[3*k + 1]) == 0.5 &&
                         numbers[1050 + 3*k + 1] == 2);
            for (k = 236; k < 350; k++)
                off += fabs((double)demi_length(at((double)numbers[3*k] + 3, (double)numbers[3*k + 1], (double)numbers[3*k + 2])) - 1) > 1e-6;
            CHECK_EQ(off, 0);
        }
        free(numbers);
        free(data);
        dem_world_destroy(w);
    }
    TEST("functions that a run calls write every kind of file, and the contacts that are written afterwards") {
        dem_world_desc desc = DEM_WORLD_DESC;
        contacts_writer by;
        dem_material m;
        int k;
        desc.gravity = at(0, 0, -9.81);
        by.world = dem_world_create(&desc);
        m = scene_material(by.world, 1e7, 0.5, 0.5, 0);
        dem_wall_plane_add(by.world, m, at(0, 0, 0), at(0, 0, 1));
        for (k = 0; k < 3; k++) dem_sphere_add(by.world, m, DEM_R(0.01), at(0.0199*k, 0, 0.01));
        by.calls = by.failed = 0;
        CHECK_EQ(dem_world_run(by.world, 1e-3, contacts_during, &by), DEM_OK);
        CHECK(by.calls > 0);
        CHECK_EQ(by.failed, 0);
        by.calls = 0;
        CHECK_EQ(dem_contacts_each(by.world, contacts_within, &by), 5);
        CHECK_EQ(by.calls, 5);
        CHECK_EQ(by.failed, 0);
        CHECK_EQ(dem_contacts_csv_write(by.world, "build/tmp/contacts_after.csv"), DEM_OK);
        CHECK_EQ(dem_contacts_vtp_write(by.world, "build/tmp/contacts_after.vtp"), DEM_OK);
        for (k = 0; k < 4; k++) {
            size_t sizes[2];
            char name[2][64], *text[2];
            int i;
            for (i = 0; i < 2; i++) {
                sprintf(name[i], "build/tmp/contacts_%s.%s", i ? "after" : k < 2 ? "during" : "within", k%2 ? "vtp" : "csv");
                text[i] = file_get(name[i], &sizes[i]);
            }
            CHECK(text[0] && text[1] && sizes[0] > 100 && sizes[0] == sizes[1] && !memcmp(text[0], text[1], sizes[0]));
            free(text[0]);
            free(text[1]);
        }
        dem_world_destroy(by.world);
    }
    TEST("a function that a run calls after the scene has changed cannot write contacts, says why, and leaves no file") {
        dem_output_desc change = DEM_OUTPUT_DESC, late = DEM_OUTPUT_DESC;
        contacts_writer by;
        FILE *none[2];
        by.world = three_make(0);
        by.calls = by.failed = 0;
        contacts_late_by = &by;
        change.kind = DEM_OUTPUT_CALL;
        change.function = contacts_change;
        change.start = late.start = 5e-5;
        change.interval = late.interval = 1;
        late.kind = DEM_OUTPUT_CSV;
        late.path = "build/tmp/late.csv";
        late.columns = "calls";
        late.values = contacts_late;
        remove("build/tmp/contacts_late.csv");
        remove("build/tmp/contacts_late.vtp");
        CHECK(dem_output_add(by.world, &change).id && dem_output_add(by.world, &late).id);
        CHECK_EQ(dem_world_run(by.world, 1e-4, 0, 0), DEM_OK);
        CHECK_EQ(by.calls, 1);
        CHECK_EQ(by.failed, 2);
        none[0] = fopen("build/tmp/contacts_late.csv", "rb");
        none[1] = fopen("build/tmp/contacts_late.vtp", "rb");
        CHECK(!none[0] && !none[1]);
        dem_world_destroy(by.world);
    }
    TEST("a union is written as one body per piece, each with its position, orientation and half axes") {
        dem_world_desc desc = DEM_WORLD_DESC;
        const dem_quat piece = dem_quat_make(DEM_R(0.8), 0, 0, DEM_R(0.6)), body = dem_quat_make(DEM_R(0.6), DEM_R(0.8), 0, 0);
        const dem_real places[6] = {DEM_R(-0.01), 0, 0, DEM_R(0.01), 0, 0}, turns[8] = {1, 0, 0, 0, DEM_R(0.8), 0, 0, DEM_R(0.6)};
        dem_world *w = dem_world_create(&desc);
        dem_material m = scene_material(w, 1e7, 0.5, 0, 0);
        dem_shape egg[2], both;
        dem_vec3 u[2];
        char *text;
        int k, j;
        egg[0] = egg[1] = dem_shape_ellipsoid_add(w, at(0.002, 0.004, 0.006));
        both = dem_shape_union_add(w, 2, egg, places, turns);
        dem_body_add(w, m, both, at(0, 0, 0), body);
        dem_sphere_add(w, m, DEM_R(0.003), at(1, 0, 0));
        CHECK_EQ(dem_xyz_write(w, "build/tmp/union.xyz"), DEM_OK);
        text = file_get("build/tmp/union.xyz", &size);
        CHECK(text != 0);
        if (text) {
            const char *line = strchr(text, '\n');
            for (k = 0; k < 3; k++) {
                const dem_quat expected = k == 2 ? dem_quat_make(1, 0, 0, 0) : k ? dem_quat_multiply(body, piece) : body;
                double x[14] = {0}, axis[3] = {0.002, 0.004, 0.006};
                line = line ? strchr(line + 1, '\n') : 0;
                CHECK(line != 0);
                if (!line) break;
                CHECK_EQ(sscanf(line, " H %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf", x, x + 1, x + 2, x + 3, x + 4,
                                x + 5, x + 6, x + 7, x + 8, x + 9, x + 10, x + 11, x + 12, x + 13), 14);
                for (j = 0; j < 3; j++) {      /* axes of the body as drawn, not the sign of its quaternion */
                    const dem_quat q = dem_quat_make((dem_real)x[10], (dem_real)x[7], (dem_real)x[8], (dem_real)x[9]);
                    u[0] = dem_quat_rotate(q, at(j == 0, j == 1, j == 2));
                    u[1] = dem_quat_rotate(expected, at(j == 0, j == 1, j == 2));
                    CHECK_NEAR((double)demi_length(demi_sub(u[0], u[1])), 0, 1e-5);
                    CHECK_NEAR(x[11 + j], k == 2 ? 0.003 : axis[j], 1e-8);
                }
            }
        }
        free(text);
        dem_world_destroy(w);
    }
    TEST("profiles cannot be drawn with z1 below z0") {
        dem_wall_profile_add(world, steel, &profile, DEM_EDGE_RESOLVED);
        CHECK_EQ(dem_walls_vtp_write(world, "build/tmp/walls.vtp", 1, 1), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "z0 is 1 m and z1 is 1 m");
    }
    TEST("wall loads are appended line by line under one heading") {
        const char *const path = "build/tmp/loads.csv";
        remove(path);
        file_put(path, "x,y,z,r\n0,0,0,1\n", 16);
        CHECK_EQ(dem_wall_loads_csv_write(world, plane, path), DEM_ERROR_FORMAT);
        CHECK_STR(dem_world_error_get(world), "has other columns than time,fx");
        char *other = file_get(path, &size);
        CHECK(other && size == 16 && !memcmp(other, "x,y,z,r\n0,0,0,1\n", 16));      /* it stays as it was */
        free(other);
        remove(path);
        CHECK_EQ(dem_wall_loads_csv_write(world, plane, path), DEM_OK);
        CHECK_EQ(dem_wall_loads_csv_write(world, plane, path), DEM_OK);
        char *text = file_get(path, &size);
        int lines = 0, commas = 0;
        CHECK(text != 0);
        for (size_t i = 0; i < size; i++) { lines += text[i] == '\n'; commas += text[i] == ','; }
        CHECK_EQ(lines, 3);
        CHECK_EQ(commas, 27);
        CHECK(text && strncmp(text, "time,fx,fy,fz,tx,ty,tz,torque_axial,power,contacts\n0,", 53) == 0);
        free(text);
        file_put(path, "", 0);
        CHECK_EQ(dem_wall_loads_csv_write(world, plane, path), DEM_OK);
        text = file_get(path, &size);
        CHECK(text && strncmp(text, "time,", 5) == 0);
        free(text);
        file_put(path, "time,fx,fy,fz,tx,ty,tz,torque_axial,power,contacts\n0.5,1,2", 58); /* cut short by a full disk */
        CHECK_EQ(dem_wall_loads_csv_write(world, plane, path), DEM_OK);
        text = file_get(path, &size);
        CHECK(text && strncmp(text + 50, "\n0.5,1,2\n0,", 11) == 0);
        free(text);
        remove(path);
    }
    TEST("writing loads of a missing wall, or into a missing folder, fails") {
        dem_wall none;
        none.id = 77;
        CHECK_EQ(dem_wall_loads_csv_write(world, none, "build/tmp/none.csv"), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "dem_wall_loads_csv_write: wall 77");
        CHECK(!file_is_there("build/tmp/none.csv"));
        CHECK_EQ(dem_wall_loads_csv_write(world, plane, "build/tmp/no_folder/x.csv"), DEM_ERROR_FILE);
        CHECK_STR(dem_world_error_get(world), "cannot write build/tmp/no_folder/x.csv: ");
        CHECK_EQ(dem_wall_loads_csv_write(world, plane, 0), DEM_ERROR_ARGUMENT);
        FILE *full = fopen("/dev/full", "rb");
        if (full) {
            fclose(full);
            CHECK_EQ(dem_wall_loads_csv_write(world, plane, "/dev/full"), DEM_ERROR_FILE);
        }
    }
    dem_mesh_free(world, &mesh);
    dem_profile_free(world, &profile);
    dem_world_destroy(world);
}

static void whole_or_absent(void) {
    scene_memory p;
    dem_world *world = three_make(&p);
    dem_mesh mesh;
    dem_wall wall;
    size_t size;
    char *text;
    parse(world, box_text, &mesh, 0);
    wall = dem_wall_mesh_add(world, material_make(world), &mesh);
    dem_mesh_free(world, &mesh);

    TEST("a writer that cannot open its file names it and the cause") {
        for (int i = 0; i < 4; i++) {
            CHECK_EQ(writers[i](world, "build/tmp/no_folder/x.out"), DEM_ERROR_FILE);
            CHECK_STR(dem_world_error_get(world), writer_names[i]);
            CHECK_STR(dem_world_error_get(world), "cannot write build/tmp/no_folder/x.out: ");
            CHECK_EQ(writers[i](world, 0), DEM_ERROR_ARGUMENT);
            CHECK_EQ(writers[i](world, "build/tmp"), DEM_ERROR_FILE); /* a folder stays a folder */
            CHECK(nothing_beside("build/tmp"));
        }
    }
    TEST("a file is replaced as a whole, and no temporary file stays") {
        for (int i = 0; i < 4; i++) {
            file_put("build/tmp/old.out", "old", 3);
            CHECK_EQ(writers[i](world, "build/tmp/old.out"), DEM_OK);
            text = file_get("build/tmp/old.out", &size);
            CHECK(size > 100);
            free(text);
            CHECK(nothing_beside("build/tmp/old.out"));
        }
        remove("build/tmp/old.out");
    }
    TEST("writing a file never touches a file or link of its name plus .tmp") {
        remove("build/tmp/victim"); remove("build/tmp/new.out.tmp");
        for (int i = 0; i < 4; i++) {
            file_put("build/tmp/victim", "mine", 4);
            if (i%2 || system("ln -s victim build/tmp/new.out.tmp") != 0)
                file_put("build/tmp/new.out.tmp", "mine", 4);
            CHECK_EQ(writers[i](world, "build/tmp/new.out"), DEM_OK);
            text = file_get("build/tmp/victim", &size);
            CHECK(size == 4 && !strncmp(text, "mine", 4));
            free(text);
            text = file_get("build/tmp/new.out.tmp", &size);
            CHECK(size == 4 && !strncmp(text, "mine", 4));
            free(text);
            remove("build/tmp/new.out.tmp");
            CHECK(nothing_beside("build/tmp/new.out"));
            remove("build/tmp/new.out");
        }
        remove("build/tmp/victim");
    }
    TEST("two writers of one name use separate temporary files, and the last one to finish wins") {
        demi_out one, two;
        CHECK_EQ(demi_out_open(&one, world, "one", "build/tmp/same.out"), DEM_OK);
        CHECK_EQ(demi_out_open(&two, world, "two", "build/tmp/same.out"), DEM_OK);
        CHECK(strcmp(one.temporary, two.temporary) != 0);
        fputs("one", one.file);
        fputs("two", two.file);
        CHECK_EQ(demi_out_close(&two), DEM_OK);
        CHECK_EQ(demi_out_close(&one), DEM_OK);
        text = file_get("build/tmp/same.out", &size);
        CHECK(size == 3 && !strncmp(text, "one", 3));
        free(text);
        CHECK(nothing_beside("build/tmp/same.out"));
        remove("build/tmp/same.out");
    }
    TEST("an empty file stays empty until its complete replacement") {
        demi_out out;
        file_put("build/tmp/empty.out", "", 0);
        CHECK_EQ(demi_out_open(&out, world, "empty", "build/tmp/empty.out"), DEM_OK);
        fputs("half", out.file);
        fflush(out.file);
        text = file_get("build/tmp/empty.out", &size);
        CHECK_EQ(size, 0);
        free(text);
        demi_out_drop(&out);
        CHECK(file_is_there("build/tmp/empty.out") && nothing_beside("build/tmp/empty.out"));
        remove("build/tmp/empty.out");
    }
    TEST("readers of meshes, profiles, grains and checkpoints reject a pipe, a device and a folder") {
        static const char *const names[] = {"build/tmp/pipe.in", "/dev/zero", "build/tmp"};
        dem_mesh read;
        dem_profile profile;
        dem_grains grains;
        remove("build/tmp/pipe.in");
        CHECK(1);
        if (system("mkfifo build/tmp/pipe.in && test -c /dev/zero") != 0) continue;
        for (int i = 0; i < 3; i++) {
            CHECK_EQ(dem_mesh_read(world, names[i], &read, 0), DEM_ERROR_FILE);
            CHECK_STR(dem_world_error_get(world), names[i]);
            CHECK_EQ(dem_profile_read(world, names[i], &profile), DEM_ERROR_FILE);
            CHECK_EQ(dem_grains_read(world, names[i], &grains), DEM_ERROR_FILE);
            CHECK_EQ(dem_checkpoint_read(world, names[i]), DEM_ERROR_FILE);
        }
        CHECK_EQ(dem_wall_loads_csv_write(world, wall, names[0]), DEM_ERROR_FILE);
        remove("build/tmp/pipe.in");
    }
    TEST("on a full disk the older file stays complete") {
        FILE *full = fopen("/dev/full", "wb");
        demi_out out;
        CHECK(1);
        if (!full) continue; /* only Linux has it */
        file_put("build/tmp/old.out", "old", 3);
        CHECK_EQ(demi_out_open(&out, world, "dem_vtp_write", "build/tmp/old.out"), DEM_OK);
        fclose(out.file);
        out.file = full;
        for (int i = 0; i < 100000; i++) demi_out_number(&out, "12345678", 8, 0);
        CHECK_EQ(demi_out_close(&out), DEM_ERROR_FILE);
        CHECK_STR(dem_world_error_get(world), "dem_vtp_write: cannot write build/tmp/old.out: No space left");
        CHECK(nothing_beside("build/tmp/old.out"));
        text = file_get("build/tmp/old.out", &size);
        CHECK(text && strcmp(text, "old") == 0);
        free(text);
        remove("build/tmp/old.out");
    }
    TEST("every failing allocation of a writer gives DEM_ERROR_MEMORY, no file and no leak") {
        for (int i = 0; i < 4; i++) {
            const size_t held = p.bytes;
            dem_result result = DEM_ERROR_MEMORY;
            for (long k = 1; k < 20; k++) {
                remove("build/tmp/memory.out");
                p.refuse = p.calls + k;
                result = writers[i](world, "build/tmp/memory.out");
                CHECK_EQ(p.bytes, held);
                if (result == DEM_OK) break;
                CHECK_EQ(result, DEM_ERROR_MEMORY);
                CHECK(!file_is_there("build/tmp/memory.out") && nothing_beside("build/tmp/memory.out"));
            }
            p.refuse = 0;
            CHECK_EQ(result, DEM_OK);
        }
        remove("build/tmp/memory.out");
    }
    dem_world_destroy(world);
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    file_put("build/tmp/probe", "", 0);
    if (!file_is_there("build/tmp/probe")) {
        printf("there is no folder build/tmp to write to: run from the root, after mkdir -p build/tmp\n");
        return 1;
    }
    remove("build/tmp/probe");
    meshes();
    bad_meshes();
    profiles();
    pictures();
    walls();
    whole_or_absent();
    TEST("named parts of STL and OBJ meshes are read one by one with only their own vertices; an unknown name is "
         "rejected with the list") {
        static const char stl[] =
            "solid shell of drum\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n"
            "solid lid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 5\nvertex 2 0 5\nvertex 0 2 5\nendloop\nendfacet\n"
            "facet normal 0 0 1\nouter loop\nvertex 2 0 5\nvertex 2 2 5\nvertex 0 2 5\nendloop\nendfacet\nendsolid lid\n";
        static const char obj[] = "g shell\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\ng lid\nv 0 0 5\nv 2 0 5\nv 2 2 5\nv 0 2 5\nf 4 5 6 7\n";
        static const char *const names[2] = {"build/tmp/parts.stl", "build/tmp/parts.obj"};
        const dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world = dem_world_create(&desc);
        dem_mesh mesh;
        dem_mesh_health health;
        int k;
        for (k = 0; k < 2; k++) {
            FILE *f = fopen(names[k], "wb");
            CHECK(f != 0);
            if (f) { fputs(k ? obj : stl, f); fclose(f); }
            CHECK_EQ(dem_mesh_part_read(world, names[k], "lid", &mesh, &health), DEM_OK);
            CHECK_EQ(mesh.triangle_count, 2);
            CHECK_EQ(mesh.vertex_count, 4);
            CHECK_NEAR(health.box.lo.z, 5, 0);
            CHECK_EQ(health.open_edges, 4);
            dem_mesh_free(world, &mesh);
            CHECK_EQ(dem_mesh_part_read(world, names[k], k ? "shell" : "shell of drum", &mesh, 0), DEM_OK);
            CHECK_EQ(mesh.triangle_count, 1);
            CHECK_EQ(mesh.vertex_count, 3);
            CHECK_NEAR(mesh.vertices[3], 1, 0);
            dem_mesh_free(world, &mesh);
            CHECK_EQ(dem_mesh_part_read(world, names[k], "door", &mesh, &health), DEM_ERROR_FORMAT);
            CHECK_STR(dem_world_error_get(world), "no triangles of a part \"door\"");
            CHECK_STR(dem_world_error_get(world), k ? "shell, lid" : "shell of drum, lid");
            CHECK(!mesh.vertices);
            CHECK_EQ(dem_mesh_read(world, names[k], &mesh, 0), DEM_OK);
            CHECK_EQ(mesh.triangle_count, 3);
            dem_mesh_free(world, &mesh);
        }
        CHECK_EQ(dem_mesh_part_read(world, names[0], 0, &mesh, 0), DEM_ERROR_ARGUMENT);
        CHECK_EQ(dem_mesh_part_read(world, "build/tmp/none.stl", "lid", &mesh, 0), DEM_ERROR_FILE);
        dem_world_destroy(world);
    }
    TEST("faces of an OBJ belong to their object and to each of their groups, as exporters write them") {
        static const char square[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
        static const struct { const char *text, *part; int triangles; } asked[] = {
            {"o Drum\ng Drum_Steel\nusemtl Steel\nf 1 2 3 4\no Lid\ng Lid_Rubber\nusemtl Rubber\nf 1 2 3\n", "Drum", 2},   /* Blender */
            {"o Drum\ng Drum_Steel\nusemtl Steel\nf 1 2 3 4\no Lid\ng Lid_Rubber\nusemtl Rubber\nf 1 2 3\n", "Lid_Rubber", 1},
            {"g shell lifters\nf 1 2 3 4\ng shell\nf 1 2 3\n", "shell", 3},
            {"g shell lifters\nf 1 2 3 4\ng shell\nf 1 2 3\n", "lifters", 2},
            {"g shell lifters\nf 1 2 3 4\ng shell\nf 1 2 3\n", "shell lifters", 2},
            {"g a\nf 1 2 3\ng b\nf 1 2 3\ng a\nf 1 2 3 4\n", "a", 3},
            {"o Shell\nf 1 2 3 4\ng\nf 1 2 3\n", "Shell", 3},                  /* a bare g ends groups, not the object */
            {"g Shell\nf 1 2 3 4\ng\nf 1 2 3\n", "Shell", 2},
            {"o Upper shell\nf 1 2 3 4\no Lower\nf 1 2 3\n", "Upper shell", 2},
            {"o Part#1\nf 1 2 3 4\no Part#2\nf 1 2 3\n", "Part#2", 1},
            {"o Part #1\nf 1 2 3 4\no Part #2\nf 1 2 3\n", "Part #2", 1},
            {"o Shell # of steel\nf 1 2 3 4\no Lid\nf 1 2 3\n", "Shell", 2},
            {"g Part#1 rest\nf 1 2 3 4\n", "Part", 2},
            {"o Shell\r\nf 1 2 \\\r\n3 4\r\n", "Shell", 2}};                   /* a line carried on */
        const dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world = dem_world_create(&desc);
        size_t k;
        for (k = 0; k < sizeof asked/sizeof *asked; k++) {
            dem_mesh mesh;
            char text[400];
            snprintf(text, sizeof text, "%s%s", square, asked[k].text);
            file_put("build/tmp/groups.obj", text, strlen(text));
            CHECK_EQ(dem_mesh_part_read(world, "build/tmp/groups.obj", asked[k].part, &mesh, 0), DEM_OK);
            CHECK_EQ(mesh.triangle_count, asked[k].triangles);
            dem_mesh_free(world, &mesh);
        }
        dem_world_destroy(world);
    }

    TEST("the name of a solid in an STL file is the whole rest of its line, a # included") {
        static const char facet[] = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
        const dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world = dem_world_create(&desc);
        dem_mesh mesh;
        char text[900];
        snprintf(text, sizeof text, "solid liner #1\n%sendsolid liner #1\nsolid liner #2\n%s%sendsolid\n", facet, facet, facet);
        file_put("build/tmp/liners.stl", text, strlen(text));
        CHECK_EQ(dem_mesh_part_read(world, "build/tmp/liners.stl", "liner #2", &mesh, 0), DEM_OK);
        CHECK_EQ(mesh.triangle_count, 2);
        dem_mesh_free(world, &mesh);
        CHECK_EQ(dem_mesh_part_read(world, "build/tmp/liners.stl", "liner", &mesh, 0), DEM_ERROR_FORMAT);
        CHECK_STR(dem_world_error_get(world), "must be one of: liner #1, liner #2");
        dem_world_destroy(world);
    }

    TEST("dem_wall_parts_add turns named parts of a file into walls with materials and motions, or adds none and says "
         "why") {
        static const char obj[] = "g shell\nv 0 0 0\nv 1000 0 0\nv 0 1000 0\nf 1 2 3\ng lid\nv 0 0 5\nv 2 0 5\nv 2 2 5\nf 4 5 6\n";
        static const char name[] = "build/tmp/machine.obj";
        const dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world = dem_world_create(&desc);
        dem_wall_part part[2];
        dem_wall wall[2];
        dem_pose pose, home;
        dem_material steel;
        uint64_t before;
        FILE *f = fopen(name, "wb");
        CHECK(f != 0);
        if (f) { fputs(obj, f); fclose(f); }
        steel = scene_material(world, 1e7, 0.5, 0.3, 0);
        memset(part, 0, sizeof part);
        part[0].name = "shell";
        part[1].name = "lid";
        part[0].material = part[1].material = steel;
        part[1].motion.kind = DEM_MOTION_TRANSLATING;
        part[1].motion.velocity = at(0, 0, 2);
        CHECK_EQ(dem_wall_parts_add(world, name, DEM_R(1e-3), 2, part, wall), DEM_OK);
        CHECK(wall[0].id == 1 && wall[1].id == 2);
        dem_wall_pose_get(world, wall[1], &home);
        dem_sphere_add(world, steel, DEM_R(0.01), at(0.3, 0.3, 0.0095));    /* on the shell; beyond it: mm became m */
        dem_sphere_add(world, steel, DEM_R(0.01), at(0.8, 0.8, 0.0095));
        CHECK_EQ(dem_world_step(world, 1), DEM_OK);
        CHECK_EQ(dem_counters_get(world).wall_contacts, 1);
        CHECK_EQ(dem_world_run_to(world, 0.01, 0, 0), DEM_OK);
        dem_wall_pose_get(world, wall[1], &pose);
        CHECK_NEAR((double)pose.position.z - (double)home.position.z, 0.02, 1e-4);
        before = dem_world_hash_get(world);
        part[1].name = "door";
        CHECK(dem_wall_parts_add(world, name, 1, 2, part, wall) != DEM_OK);
        CHECK_STR(dem_world_error_get(world), "dem_wall_parts_add");
        CHECK_STR(dem_world_error_get(world), "door");
        CHECK(!wall[0].id && !wall[1].id);
        CHECK_EQ(dem_wall_parts_add(world, "build/tmp/none.obj", 1, 2, part, wall), DEM_ERROR_FILE);
        part[1].name = "lid";
        CHECK_EQ(dem_wall_parts_add(world, name, (dem_real)NAN, 2, part, wall), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "dem_wall_parts_add");
        CHECK(!wall[0].id && !wall[1].id);
        part[1].motion.velocity.x = (dem_real)NAN;
        CHECK(dem_wall_parts_add(world, name, 1, 2, part, 0) != DEM_OK);
        part[1].motion.velocity.x = 0;
        part[1].material.id = 7;
        CHECK(dem_wall_parts_add(world, name, 1, 2, part, 0) != DEM_OK);
        CHECK_STR(dem_world_error_get(world), "material 7");
        wall[0].id = 3;
        CHECK_EQ(dem_wall_pose_get(world, wall[0], &pose), DEM_ERROR_ARGUMENT);
        CHECK_EQ(dem_candidates_rebuild(world), DEM_OK);
        CHECK(dem_world_hash_get(world) == before);
        CHECK_EQ(dem_world_run_to(world, 0.02, 0, 0), DEM_OK);
        dem_world_destroy(world);
        remove(name);
    }
    return test_end();
}
