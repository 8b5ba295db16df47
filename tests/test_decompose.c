/* Spheres that stand for a mesh: a cube, a flake, a body with ears. DECOMPOSE_NUMBERS=1 prints the table of
   docs/shapes.md. */
#define DEM_IMPLEMENTATION
#include "../dem.h"
#include "test.h"
#include "scene.h"

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

int main(int argc, char **argv) {
    static const char *const names[] = {"cube", "flake", "bunny"};
    const int table = getenv("DECOMPOSE_NUMBERS") != 0;
    const int fine = sizeof(dem_real) == 8;
    test_begin(argc, argv);

    TEST("more spheres stand for a mesh better: fewer points wrong, volume, moments and surface nearer; the mesh's own volume, "
         "centre and moments are exact") {
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

    TEST("a cluster of the spheres, with the mesh's moments given, weighs and turns as the mesh; inside out is the same mesh; "
         "what is open, thin or not there is refused") {
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
        CHECK_STR(dem_world_error(w), "vertex 99");
        CHECK(!dem_shape_mesh_add(w, &mesh, 0).id);
        CHECK_STR(dem_world_error(w), "vertex 99");
        mesh.triangles[4] = swap;
        mesh.triangle_count = 2;
        CHECK_EQ(dem_mesh_spheres(w, &mesh, 1, x, r, 0), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error(w), "closed");
        mesh = block(1, 1, 1e-4);
        CHECK_EQ(dem_mesh_spheres(w, &mesh, 1, x, r, 0), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error(w), "thinner");
        dem_world_destroy(w);
    }
    return test_end();
}
