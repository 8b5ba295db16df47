/* heap.c - a study, the long form of 10_clusters.c: 2000 tetrahedra of four touching spheres fill a tube, the tube is
   pulled up, and a heap remains. Then 2000 spheres of the same volume and material do the same. Tetrahedra interlock
   and hardly roll, so their heap is steeper, although only the spheres have rolling resistance. Both heaps come to rest.

   The slope is that of the cone with the same centre of mass and the same mean distance from its axis:
       tan(slope) = H/R,   H = 4 (z_mean - z of the lowest layer),   R = 2 r_mean
   A heap is at rest if its kinetic energy is below 1e-9 of the energy of the fall, also 0.2 s later.

   Build:     make build/heap, or cc -O2 -o heap heap.c ../dem.c -lm      (in the folder examples)
   Run:       ./heap             five minutes on one core
              ./heap --quick     with 500 grains of each kind: one minute
   Output:    slopes of about 20 degrees (tetrahedra) and 9 degrees (spheres); pictures heap_tetrahedra.svg and
              heap_spheres.svg; heap_*.vtp for ParaView */
#include "../dem.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TETRAHEDRA, SPHERES };
static const char *const names[] = {"tetrahedra", "spheres"};

/* Four touching spheres of radius r at the corners of a tetrahedron. */
static dem_shape tetrahedron(dem_world *world, dem_real r) {
    static const int corner[12] = {1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1};
    dem_cluster_desc desc = DEM_CLUSTER_DESC;
    dem_real x[12];
    for (int i = 0; i < 12; i++) x[i] = (dem_real)(corner[i]*(double)r/sqrt(2.0));
    desc.count = 4;
    desc.positions = x;
    desc.radius = r;
    return dem_shape_cluster_add(world, &desc);
}

static int farther(const void *a, const void *b) {          /* x y z radius id; y points into the picture */
    const double *p = (const double *)a, *q = (const double *)b;
    return (p[1] < q[1]) - (p[1] > q[1]);
}
/* Adds a tube about the z axis that moves up from 0.25 s on. */
static void tube(dem_world *world, dem_material material, double radius, double height) {
    enum { SIDES = 24 };
    dem_real vertices[2*SIDES*3];
    int32_t triangles[2*SIDES*3];
    dem_mesh mesh = {2*SIDES, 2*SIDES, vertices, triangles};
    dem_motion motion = DEM_MOTION;
    for (int i = 0; i < SIDES; i++) {
        const int next = (i + 1)%SIDES;
        for (int k = 0; k < 2; k++) {
            dem_real *v = vertices + 3*(2*i + k);
            v[0] = (dem_real)(radius*cos(2*3.14159265358979*i/SIDES));
            v[1] = (dem_real)(radius*sin(2*3.14159265358979*i/SIDES));
            v[2] = (dem_real)(k*height);
        }
        const int32_t two[6] = {2*i, 2*next, 2*next + 1, 2*i, 2*next + 1, 2*i + 1};
        for (int k = 0; k < 6; k++) triangles[6*i + k] = two[k];
    }
    motion.kind = DEM_MOTION_TRANSLATING;
    motion.velocity.z = DEM_R(0.15);                                /* m/s */
    motion.start = 0.25;                                            /* s: all have fallen */
    dem_wall_motion_set(world, dem_wall_mesh_add(world, material, &mesh), &motion);
}

/* Draws the heap from the side, each sphere as a disc, the farthest first. */
static void draw(const char *path, double *ball, int count) {
    FILE *file = fopen(path, "w");
    if (!file) return;
    qsort(ball, (size_t)count, 5*sizeof *ball, farther);
    fprintf(file, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-75 -45 150 50\" width=\"900\" height=\"300\">\n"
            "<rect x=\"-75\" y=\"-45\" width=\"150\" height=\"50\" fill=\"#fff\"/>\n"
            "<rect x=\"-75\" y=\"0\" width=\"150\" height=\"5\" fill=\"#888\"/>\n");
    for (int i = 0; i < count; i++) {
        const double *b = ball + 5*i, near_by = 0.5 - b[1]/0.12;
        const int hue = (int)b[4]*47%360, light = (int)(35 + 35*fmin(fmax(near_by, 0), 1));
        fprintf(file, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\" fill=\"hsl(%d,45%%,%d%%)\" stroke=\"#222\" "
                "stroke-width=\".08\"/>\n", 1e3*b[0], -1e3*b[2], 1e3*b[3], hue, light);
    }
    fputs("</svg>\n", file);
    fclose(file);
}

int main(int argc, char **argv) {
    const int quick = argc == 2 && !strcmp(argv[1], "--quick"), count = quick ? 500 : 2000;
    const dem_real radius = 1e-3;                                   /* m, of a tetrahedron's spheres */
    double slope[2], rest[2] = {0, 0};
    if (argc > 1 && !quick) {
        puts("heap [--quick]: a heap of 2000 (500) tetrahedra and one of as many spheres: slopes, kinetic energies at rest, "
             "pictures");
        return strcmp(argv[1], "--help") ? 2 : 0;
    }
    for (int kind = 0; kind < 2; kind++) {
        dem_world_desc desc = DEM_WORLD_DESC;
        desc.gravity.z = DEM_R(-9.81);                              /* m/s2 */
        desc.normal_law = DEM_NORMAL_LINEAR;
        desc.dt = DEM_R(1e-5);                                      /* s, about 1/26 of the shortest contact */
        dem_world *world = dem_world_create(&desc);
        dem_material_desc gravel_desc = DEM_MATERIAL_DESC;
        gravel_desc.density = 2500;                                 /* kg/m3 */
        gravel_desc.stiffness = 1500;                               /* N/m */
        gravel_desc.restitution = DEM_R(0.3);
        gravel_desc.friction = DEM_R(0.5);
        if (kind == SPHERES) gravel_desc.rolling_friction = DEM_R(0.05);    /* otherwise they roll away */
        dem_material gravel = dem_material_add(world, &gravel_desc);
        dem_wall_plane_add(world, gravel, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
        tube(world, gravel, 0.027, 0.5);

        dem_shape shape = tetrahedron(world, radius);
        dem_shape_info info;
        if (dem_shape_get(world, shape, &info) != DEM_OK) { puts(dem_world_error_get(world)); return 1; }
        const dem_real same = (dem_real)cbrt(3*(double)info.volume/(4*3.14159265358979));
        const dem_box box = dem_box_make(DEM_R(-0.018), DEM_R(-0.018), 0, DEM_R(0.018), DEM_R(0.018),
                                         DEM_R(0.40)*(dem_real)count/2000);
        const int placed = kind == TETRAHEDRA ? dem_bodies_fill(world, gravel, shape,
                                                                dem_region_make(box), count, 1)
                                              : dem_spheres_fill(world, gravel, same,
                                                                 dem_region_make(box), count, 1);
        if (placed < count) { puts(dem_world_error_get(world)); return 1; }

        /* the grains fall and come to rest; their kinetic energy then, and 0.2 s later */
        dem_world_check_print(world, stdout);
        const dem_totals before = dem_totals_get(world);
        const double fall = before.mass*9.81*before.centre[2];      /* J, energy of the fall to the floor */
        double still[2] = {0, 0}, height[2] = {0, 0};
        for (int late = 0; late < 2; late++) {
            if (dem_world_run(world, late ? 0.2 : 1.2, dem_progress_print, stderr) != DEM_OK) {
                puts(dem_world_error_get(world));
                return 1;
            }
            const dem_totals t = dem_totals_get(world);
            still[late] = (t.kinetic + t.rotational)/fall;
            height[late] = t.centre[2];
        }

        /* the cone with this centre of mass and mean distance from the axis; grains beyond 60 mm do not count */
        const dem_bodies all = dem_bodies_get(world);
        double *ball = (double *)calloc((size_t)count*4, 5*sizeof *ball);
        double sum = 0, high = 0;
        int balls = 0, heap = 0;
        for (int i = 0; i < all.count; i++) {
            const dem_real *x = all.positions + 4*i;
            const double r = sqrt((double)(x[0]*x[0] + x[1]*x[1]));
            dem_quat q = dem_quat_make(1, 0, 0, 0);
            if (all.orientations) q = dem_quat_make(all.orientations[4*i], all.orientations[4*i + 1],
                                                    all.orientations[4*i + 2], all.orientations[4*i + 3]);
            for (int k = 0; k < (kind == TETRAHEDRA ? 4 : 1); k++) {    /* the frame of the corners has principal axes */
                static const int corner[12] = {1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1};
                const dem_real a = kind == TETRAHEDRA ? (dem_real)((double)radius/sqrt(2.0)) : 0;
                const dem_vec3 c = dem_quat_rotate(q, dem_vec3_make(a*(dem_real)corner[3*k], a*(dem_real)corner[3*k + 1],
                                                                  a*(dem_real)corner[3*k + 2]));
                double *b = ball + 5*balls++;
                b[0] = (double)(x[0] + c.x); b[1] = (double)(x[1] + c.y); b[2] = (double)(x[2] + c.z);
                b[3] = kind == TETRAHEDRA ? (double)radius : (double)x[3];
                b[4] = all.slots[i];
            }
            if (r > 0.06) continue;
            sum += r;
            high += (double)x[2];
            heap++;
        }
        slope[kind] = atan(4*(high/heap - (double)same)/(2*sum/heap))*180/3.14159265358979;
        rest[kind] = still[1];
        printf("%-10s  slope %4.1f degrees, %d grains in the heap; kinetic energy over energy of the fall %.1e, 0.2 s "
               "later %.1e; centre of mass sank by %.1e m meanwhile\n",
               names[kind], slope[kind], heap, still[0], still[1], height[0] - height[1]);
        char path[64];
        snprintf(path, sizeof path, "heap_%s.svg", names[kind]);
        draw(path, ball, balls);
        snprintf(path, sizeof path, "heap_%s.vtp", names[kind]);
        dem_vtp_write(world, path);
        free(ball);
        dem_world_destroy(world);
    }
    if (rest[TETRAHEDRA] < 1e-9 && slope[TETRAHEDRA] > slope[SPHERES]) return 0;
    puts("not as expected");
    return 1;
}
