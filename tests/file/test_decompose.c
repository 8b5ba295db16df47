/* Spheres that stand for a mesh: a cube, a flake, a body with ears. DECOMPOSE_NUMBERS=1 prints the table of
   docs/shapes.md. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static dem_mesh block(double a, double b, double c) {
    static dem_real v[24];
    static int32_t t[36] = {0,2,3, 0,3,1, 4,5,7, 4,7,6, 0,1,5, 0,5,4, 2,6,7, 2,7,3, 0,4,6, 0,6,2, 1,3,7, 1,7,5};
    dem_mesh m = {8, 12, v, t};
    int i;
    for (i = 0; i < 8; i++) {
        v[3*i] = (dem_real)(i & 1 ? a : 0);
        v[3*i + 1] = (dem_real)(i & 2 ? b : 0);
        v[3*i + 2] = (dem_real)(i & 4 ? c : 0);
    }
    return m;
}
/* A smooth body with a head, two ears and a tail: a sphere of .6 with bumps, narrower along y. */
enum { AROUND = 48, DOWN = 24 };
static double bump(double x, double y, double z, double a, double b, double c, double sharp) {
    return exp(-sharp*((x - a)*(x - a) + (y - b)*(y - b) + (z - c)*(z - c)));
}
static dem_mesh bunny(void) {
    static dem_real v[3*(AROUND*DOWN + 2)];
    static int32_t t[6*AROUND*DOWN];
    dem_mesh m = {0, 0, v, t};
    int n = 0, k = 0, i, j;
    for (j = 1; j < DOWN; j++)
        for (i = 0; i < AROUND; i++) {
            const double a = 3.14159265358979323846*j/DOWN, f = 6.28318530717958647692*i/AROUND;
            const double x = sin(a)*cos(f), y = sin(a)*sin(f), z = cos(a);
            const double r = 0.6 + 0.55*bump(x, y, z, 0.5, 0, 0.8, 12) + 0.9*bump(x, y, z, 0.35, 0.3, 0.88, 40) +
                0.9*bump(x, y, z, 0.35, -0.3, 0.88, 40) + 0.15*bump(x, y, z, -0.95, 0, -0.3, 20);
            v[n++] = (dem_real)(r*x);
            v[n++] = (dem_real)(0.8*r*y);
            v[n++] = (dem_real)(r*z);
        }
    v[n++] = 0; v[n++] = 0; v[n++] = DEM_R(0.75);
    v[n++] = 0; v[n++] = 0; v[n++] = DEM_R(-0.6);
    for (j = 0; j < DOWN - 2; j++)
        for (i = 0; i < AROUND; i++) {
            const int a = j*AROUND + i, b = j*AROUND + (i + 1)%AROUND;
            const int six[6] = {a, a + AROUND, b, b, a + AROUND, b + AROUND};
            int e;
            for (e = 0; e < 6; e++) t[k++] = six[e];
        }
    for (i = 0; i < AROUND; i++) {
        const int last = (DOWN - 2)*AROUND, top = n/3 - 2, next = (i + 1)%AROUND;
        const int six[6] = {top, i, next, top + 1, last + next, last + i};
        int e;
        for (e = 0; e < 6; e++) t[k++] = six[e];
    }
    m.vertex_count = n/3;
    m.triangle_count = k/3;
    return m;
}

/* Boxes in one mesh, each with vertices of its own. */
static dem_real pile_vertices[3*64];
static int32_t pile_triangles[3*96];
static dem_mesh pile;
static void pile_begin(void) {
    memset(&pile, 0, sizeof pile);
    pile.vertices = pile_vertices;
    pile.triangles = pile_triangles;
}
static void pile_turn(int triangle) {
    int32_t *t = pile.triangles + 3*triangle, first = t[0];
    t[0] = t[1];
    t[1] = first;
}
static void pile_again(int triangle) {
    memcpy(pile.triangles + 3*pile.triangle_count++, pile.triangles + 3*triangle, 3*sizeof(int32_t));
}
static void pile_box(double lo, double hi, double x, int inward) {       /* a cube from lo to hi, moved by x */
    static const int sides[12][3] = {{0,2,3},{0,3,1},{4,5,7},{4,7,6},{0,1,5},{0,5,4},{2,6,7},{2,7,3},{0,4,6},{0,6,2},{1,3,7},{1,7,5}};
    int i, k;
    for (i = 0; i < 12; i++) {
        for (k = 0; k < 3; k++) pile.triangles[3*pile.triangle_count + k] = pile.vertex_count + sides[i][k];
        pile.triangle_count++;
        if (inward) pile_turn(pile.triangle_count - 1);
    }
    for (i = 0; i < 8; i++, pile.vertex_count++)
        for (k = 0; k < 3; k++)
            pile.vertices[3*pile.vertex_count + k] = (dem_real)((i >> k & 1 ? hi : lo) + (k == 0 ? x : 0));
}
/* The volume that dem_mesh_spheres finds; -1: it refuses, with these words. */
static double pile_volume(dem_world *w, const char *why) {
    dem_real x[3], r[1];
    dem_spheres_fit fit;
    if (dem_mesh_spheres(w, &pile, 1, x, r, &fit) == DEM_OK) return (double)fit.volume;
    CHECK_STR(dem_world_error_get(w), why);
    return -1;
}
/* What health says of it, written as an OBJ. */
static dem_mesh_health pile_health(dem_world *w) {
    static char text[9000];
    dem_mesh_health health;
    dem_mesh mesh;
    size_t n = 0;
    int i;
    for (i = 0; i < pile.vertex_count; i++)
        n += (size_t)sprintf(text + n, "v %g %g %g\n", (double)pile.vertices[3*i], (double)pile.vertices[3*i + 1],
                             (double)pile.vertices[3*i + 2]);
    for (i = 0; i < pile.triangle_count; i++)
        n += (size_t)sprintf(text + n, "f %d %d %d\n", (int)pile.triangles[3*i] + 1, (int)pile.triangles[3*i + 1] + 1,
                             (int)pile.triangles[3*i + 2] + 1);
    CHECK_EQ(dem_mesh_parse(w, "pile.obj", text, n, &mesh, &health), DEM_OK);
    dem_mesh_free(w, &mesh);
    return health;
}

int main(int argc, char **argv) {
    static const char *const names[] = {"cube", "flake", "bunny"};
    const int table = getenv("DECOMPOSE_NUMBERS") != 0;
    const int fine = sizeof(dem_real) == 8;
    test_begin(argc, argv);

    TEST("more spheres fit a mesh better in points, volume, moments and surface; the mesh's own moments are exact") {
        static dem_real x[3*128], r[128];
        const dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *w = dem_world_create(&desc);
        int body;
        int count;
        for (body = 0; body < 3; body++) {
            const dem_mesh mesh = body == 0 ? block(1, 1, 1) : body == 1 ? block(1, 0.8, 0.15) : bunny();
            double wrong = 2;
            dem_spheres_fit fit;
            for (count = 1; count <= (table ? 128 : 16); count *= table ? 2 : 4) {
                CHECK_EQ(dem_mesh_spheres(w, &mesh, count, x, r, &fit), DEM_OK);
                CHECK((double)fit.wrong < wrong);
                wrong = (double)fit.wrong;
                if (table) printf("| %s | %d | %+.3f | %.3f | %.4f | %.3f |\n", names[body], count, (double)fit.volume_error,
                                  (double)fit.inertia_error, (double)fit.surface_error, wrong);
            }
            if (body == 0) {
                CHECK_NEAR((double)fit.volume, 1, fine ? 1e-14 : 1e-6);
                CHECK_NEAR((double)fit.centre.z, 0.5, fine ? 1e-14 : 1e-6);
                CHECK_NEAR((double)fit.inertia[0], 1/6.0, fine ? 1e-14 : 1e-6);
                CHECK_NEAR((double)fit.inertia[5], 0, fine ? 1e-14 : 1e-6);
            }
            if (body == 2) CHECK(fabs((double)fit.volume_error) < 0.05 && wrong < 0.15);
        }
        dem_world_destroy(w);
    }

    TEST("a cluster of fitted spheres with given moments weighs and rotates as the mesh; open, thin or missing meshes "
         "are rejected") {
        static dem_real x[3*8], r[8];
        const dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *w = dem_world_create(&desc);
        dem_mesh mesh = block(0.02, 0.03, 0.05);
        dem_cluster_desc cluster = DEM_CLUSTER_DESC;
        dem_spheres_fit fit, other;
        dem_shape_info info;
        int32_t swap;
        int i;
        CHECK_EQ(dem_mesh_spheres(w, &mesh, 8, x, r, &fit), DEM_OK);
        cluster.count = 8;
        cluster.positions = x;
        cluster.radii = r;
        cluster.mass = DEM_CLUSTER_GIVEN;
        cluster.volume = fit.volume;
        cluster.centre = fit.centre;
        memcpy(cluster.inertia, fit.inertia, sizeof cluster.inertia);
        CHECK_EQ(dem_shape_get(w, dem_shape_cluster_add(w, &cluster), &info), DEM_OK);
        CHECK_NEAR((double)info.volume/3e-5, 1, 1e-6);
        CHECK_NEAR((double)(info.inertia.x + info.inertia.y + info.inertia.z)/(3e-5*(4e-4 + 9e-4 + 25e-4)/6), 1, 1e-5);
        for (i = 0; i < mesh.triangle_count; i++) {
            swap = mesh.triangles[3*i];
            mesh.triangles[3*i] = mesh.triangles[3*i + 1];
            mesh.triangles[3*i + 1] = swap;
        }
        CHECK_EQ(dem_mesh_spheres(w, &mesh, 8, x, r, &other), DEM_OK);
        CHECK_NEAR((double)other.volume, (double)fit.volume, 1e-12);
        CHECK_NEAR((double)other.wrong, (double)fit.wrong, 1e-6);
        CHECK_EQ(dem_mesh_spheres(w, &mesh, 0, x, r, 0), DEM_ERROR_ARGUMENT);
        CHECK_EQ(dem_mesh_spheres(w, &mesh, 1, 0, r, 0), DEM_ERROR_ARGUMENT);
        swap = mesh.triangles[4];
        mesh.triangles[4] = 99;
        CHECK_EQ(dem_mesh_spheres(w, &mesh, 1, x, r, 0), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(w), "vertex 99");
        CHECK(!dem_shape_mesh_add(w, &mesh, 0).id);
        CHECK_STR(dem_world_error_get(w), "vertex 99");
        mesh.triangles[4] = swap;
        mesh.triangle_count = 2;
        CHECK_EQ(dem_mesh_spheres(w, &mesh, 1, x, r, 0), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(w), "so it has no inside");
        mesh = block(1, 1, 1e-4);
        CHECK_EQ(dem_mesh_spheres(w, &mesh, 1, x, r, 0), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(w), "thinner");
        dem_world_destroy(w);
    }
    TEST("a closed mesh has the same volume and hull for any winding of its triangles, and its health counts reversed "
         "ones") {
        const dem_world_desc desc = DEM_WORLD_DESC;
        const double exact = sizeof(dem_real) == 8 ? 1e-12 : 1e-6;       /* sums of 12 products */
        dem_world *w = dem_world_create(&desc);
        uint64_t random = 11;
        int trial, i;
        for (trial = 0; trial < 16; trial++) {
            dem_shape_info info;
            int turned = 0;
            pile_begin();
            pile_box(0, 1, trial%3*7, 0);
            for (i = 0; i < 12; i++)
                if (trial < 12 ? i == trial : scene_random(&random) < 0.5) { pile_turn(i); turned++; }
            CHECK_NEAR(pile_volume(w, ""), 1, exact);
            CHECK_EQ(dem_shape_get(w, dem_shape_mesh_add(w, &pile, 0), &info), DEM_OK);
            CHECK_NEAR((double)info.volume, 1, sizeof(dem_real) == 8 ? 1e-10 : 1e-5);
            CHECK_EQ(pile_health(w).flipped, turned < 6 ? turned : 12 - turned);
            CHECK_EQ(pile_health(w).shells, 1);
        }
        dem_world_destroy(w);
    }

    TEST("separate shells add up, an inner shell of opposite winding is a cavity, and duplicate triangles count once") {
        const dem_world_desc desc = DEM_WORLD_DESC;
        const double exact = sizeof(dem_real) == 8 ? 1e-12 : 1e-6;
        dem_world *w = dem_world_create(&desc);
        int inward;
        for (inward = 0; inward < 2; inward++) {        /* written outward or, as a whole, inside out */
            pile_begin();
            pile_box(0, 1, 0, inward);
            pile_box(0, 1, 3, !inward);                 /* beside it, the other way round: another body */
            CHECK_NEAR(pile_volume(w, ""), 2, exact);
            CHECK_EQ(pile_health(w).shells, 2);
            pile_begin();
            pile_box(0, 1, 0, inward);
            pile_box(0.25, 0.75, 0, !inward);           /* a cavity */
            CHECK_NEAR(pile_volume(w, ""), 0.875, exact);
            pile_box(0.4, 0.6, 0, inward);              /* a core in the cavity */
            CHECK_NEAR(pile_volume(w, ""), 0.883, exact);
            pile_turn(13);                              /* of the cavity */
            CHECK_NEAR(pile_volume(w, ""), 0.883, exact);
            pile_begin();
            pile_box(0, 1, 0, inward);
            pile_again(4);
            pile_again(4);
            CHECK_NEAR(pile_volume(w, ""), 1, exact);
            pile_begin();
            pile_box(0, 1, 0, inward);
            pile_box(0, 1, 1, inward);                  /* side by side: the wall between them is there twice */
            CHECK_NEAR(pile_volume(w, ""), 2, exact);
        }
        pile_begin();
        for (inward = 0; inward < 7; inward++) pile_box(0, 1, 7 - 1.5*inward, inward%2);     /* seven bodies */
        CHECK_NEAR(pile_volume(w, ""), 7, exact);
        dem_world_destroy(w);
    }

    TEST("every failing allocation in mesh decomposition gives a memory error and leaves nothing behind") {
        dem_world_desc desc = DEM_WORLD_DESC;
        scene_memory memory;
        dem_world *w;
        int what;
        scene_memory_use(&memory, &desc);
        w = dem_world_create(&desc);
        pile_begin();
        pile_box(0, 1, 0, 0);
        pile_turn(3);
        for (what = 0; what < 2; what++) {
            const size_t before = memory.bytes;
            dem_real x[3], r[1];
            int made = 0;
            long k;
            for (k = 1; k < 60 && !made; k++) {
                memory.refuse = memory.calls + k;
                memory.refused = 0;
                made = what ? dem_shape_mesh_add(w, &pile, 0).id != 0 : dem_mesh_spheres(w, &pile, 1, x, r, 0) == DEM_OK;
                CHECK_EQ(made, !memory.refused);
                if (made) break;
                CHECK_STR(dem_world_error_get(w), "memory");
                CHECK_EQ(memory.bytes, before);
            }
            CHECK(made && k > 5);
            memory.refuse = 0;
        }
        dem_world_destroy(w);
        CHECK_EQ(memory.bytes, 0);
    }

    TEST("open, branched, one-sided, crossing and nested meshes have no inside and are rejected as bodies") {
        static const int32_t strip[15] = {0, 1, 2, 1, 3, 2, 2, 3, 4, 3, 0, 4, 4, 0, 1};      /* a Moebius strip of five */
        const dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *w = dem_world_create(&desc);
        int i;
        for (i = 0; i < 3; i++) {
            pile_begin();
            pile_box(0, 1, -i, 0);
            pile.triangle_count -= i + 1;               /* no lid, or half of one */
            CHECK_NEAR(pile_volume(w, "open"), -1, 0);
            CHECK(!dem_shape_mesh_add(w, &pile, 1).id);
            CHECK_STR(dem_world_error_get(w), "dem_shape_mesh_add: the mesh is open at");
            CHECK(pile_health(w).open_edges > 2);
        }
        pile_begin();
        pile_box(0, 1, 0, 0);
        pile_again(0);
        pile.vertices[3*pile.vertex_count] = pile.vertices[3*pile.vertex_count + 1] = pile.vertices[3*pile.vertex_count + 2] = -1;
        pile.triangles[3*pile.triangle_count - 1] = pile.vertex_count++;         /* a fin at an edge */
        CHECK_NEAR(pile_volume(w, "more than two triangles"), -1, 0);
        pile_begin();
        pile_box(0, 1, 0, 0);
        pile_box(0.5, 1.5, 0.1, 0);
        CHECK_NEAR(pile_volume(w, "shells of the mesh cross"), -1, 0);
        pile_begin();
        pile_box(0, 1, 0, 0);
        pile_box(0.25, 0.75, 0, 0);
        CHECK_NEAR(pile_volume(w, "faces the same way"), -1, 0);
        pile_begin();
        pile_box(0, 1, 0, 0);
        memcpy(pile.triangles, strip, sizeof strip);
        pile.triangle_count = 5;
        CHECK_NEAR(pile_volume(w, "one-sided"), -1, 0);
        CHECK(pile_health(w).twisted_edges > 0);
        dem_world_destroy(w);
    }
    return test_end();
}
