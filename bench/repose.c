/* repose.c - heaps of spheres, of cubes as polyhedra and of cubes made of spheres: the slope of each, and what it costs.
   A tube on a floor is filled with grains of one volume and then drawn up; the slope is that of the cone with the heap's
   centre of mass and mean distance from its axis, as in examples/heap.c.

   Build:    make build/repose
   Run:      repose [KIND] [--count N] [--film]      KIND: spheres, cubes, cubes4, cubes8, cubes27, cubes64, cubes100; all
             of them one after the other take hours on one core; --film writes repose_KIND.html */
#define DEM_IMPLEMENTATION
#include "../dem.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const double edge = 3e-3;                /* m */
/* A cube as a polyhedron (spheres 0), or as so many spheres with the cube's own mass and moments. */
static dem_shape cube(dem_world *world, int spheres, dem_spheres_fit *fit) {
    static const int32_t triangles[36] = {0,2,3, 0,3,1, 4,5,7, 4,7,6, 0,1,5, 0,5,4, 2,6,7, 2,7,3, 0,4,6, 0,6,2, 1,3,7, 1,7,5};
    static dem_real x[3*100], r[100];
    dem_cluster_desc desc = DEM_CLUSTER_DESC;
    dem_real points[24];
    int32_t corners[36];
    dem_mesh mesh = {8, 12, points, corners};
    dem_shape none = {0};
    int i;
    memcpy(corners, triangles, sizeof corners);
    for (i = 0; i < 24; i++) points[i] = (dem_real)((i/3 >> i%3 & 1 ? 0.5 : -0.5)*edge);
    memset(fit, 0, sizeof *fit);
    if (!spheres) return dem_shape_polyhedron_add(world, 8, points);
    if (dem_mesh_spheres(world, &mesh, spheres, x, r, fit) != DEM_OK) return none;
    desc.count = spheres;
    desc.positions = x;
    desc.radii = r;
    desc.mass = DEM_CLUSTER_GIVEN;
    desc.volume = fit->volume;
    desc.centre = fit->centre;
    memcpy(desc.inertia, fit->inertia, sizeof desc.inertia);
    return dem_shape_cluster_add(world, &desc);
}
/* A tube of triangles about the z axis, drawn up from .45 s on. */
static void tube(dem_world *world, dem_material material, double radius, double height) {
    enum { SIDES = 24 };
    dem_real vertices[2*SIDES*3];
    int32_t triangles[2*SIDES*3];
    dem_mesh mesh = {2*SIDES, 2*SIDES, vertices, triangles};
    dem_motion motion = DEM_MOTION;
    int i, k;
    for (i = 0; i < SIDES; i++) {
        const int next = (i + 1)%SIDES, two[6] = {2*i, 2*next, 2*next + 1, 2*i, 2*next + 1, 2*i + 1};
        for (k = 0; k < 2; k++) {
            vertices[3*(2*i + k)] = (dem_real)(radius*cos(2*3.14159265358979*i/SIDES));
            vertices[3*(2*i + k) + 1] = (dem_real)(radius*sin(2*3.14159265358979*i/SIDES));
            vertices[3*(2*i + k) + 2] = (dem_real)(k*height);
        }
        for (k = 0; k < 6; k++) triangles[6*i + k] = two[k];
    }
    motion.kind = DEM_MOTION_TRANSLATING;
    motion.velocity.z = DEM_R(0.15);
    motion.start = 0.45;
    dem_wall_motion(world, dem_mesh_add(world, material, &mesh), &motion);
}
static int heap(const char *kind, int count, int film) {
    const int round = !strcmp(kind, "spheres"), spheres = atoi(kind + 5);
    const dem_real same = (dem_real)(edge*0.6203504908994);         /* m, radius of the sphere of its volume */
    const dem_box box = dem_box_make(DEM_R(-0.0085), DEM_R(-0.0085), DEM_R(0.004), DEM_R(0.0085), DEM_R(0.0085),
                                     (dem_real)(0.9*count/500));
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc gravel = DEM_MATERIAL_DESC;
    dem_replay_desc film_desc = DEM_REPLAY_DESC;
    dem_replay *replay = 0;
    dem_spheres_fit fit;
    dem_repose slope;
    dem_world *world;
    dem_material m;
    dem_shape shape = {0};
    double sum = 0, high = 0, spent, inside = 0;
    char path[64];
    int i, placed;
    desc.gravity.z = DEM_R(-9.81);
    desc.normal_law = DEM_NORMAL_LINEAR;
    desc.dt = DEM_R(5e-6);
    desc.threads = 1;
    world = dem_world_create(&desc);
    gravel.density = 2500;
    gravel.stiffness = 3000;
    gravel.restitution = DEM_R(0.3);
    gravel.friction = DEM_R(0.5);
    if (round) gravel.rolling_friction = DEM_R(0.05);       /* or they would roll away */
    m = dem_material_add(world, &gravel);
    dem_plane_add(world, m, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
    tube(world, m, 0.0125, 1.0*count/500);
    if (!round) shape = cube(world, spheres, &fit);
    placed = round ? dem_spheres_fill(world, m, same, box, count, 1) : dem_bodies_fill(world, m, shape, box, count, 1);
    snprintf(path, sizeof path, "repose_%s.html", kind);
    film_desc.interval = 0.05;
    if (film) replay = dem_replay_open(world, path, &film_desc);
    spent = (double)clock();
    if (placed < count || dem_world_run(world, 1.4, dem_progress_print, stderr) != DEM_OK) {
        puts(dem_world_error(world));
        return 1;
    }
    spent = ((double)clock() - spent)/CLOCKS_PER_SEC;
    if (replay) dem_replay_close(replay);
    for (i = 0; i < count; i++) {
        const dem_real *x = dem_bodies_get(world).positions + 4*i;
        const double r = sqrt((double)(x[0]*x[0] + x[1]*x[1]));
        if (r > 0.06) continue;
        sum += r;
        high += (double)x[2];
        inside++;
    }
    printf("%s.slope = %.1f degrees\n", kind, atan(4*(high/inside - (double)same)/(2*sum/inside))*180/3.14159265358979);
    if (dem_repose_heap(world, (dem_box){{0, 0, 0}, {0, 0, 0}}, &slope) == DEM_OK)
        printf("%s.flank = %.1f degrees\n%s.flank_error = %.1f degrees\n", kind, (double)slope.angle*180/3.14159265358979,
               kind, (double)slope.error*180/3.14159265358979);
    printf("%s.heap = %g\n%s.kinetic = %.2g J\n", kind, inside, kind,
           dem_totals_get(world).kinetic + dem_totals_get(world).rotational);
    printf("%s.time = %.1f s/s\n%s.contacts = %d\n", kind, spent/1.4, kind, dem_counters_get(world).contacts);
    if (spheres) printf("%s.wrong = %.3f\n", kind, (double)fit.wrong);
    fflush(stdout);
    dem_world_destroy(world);
    return 0;
}
int main(int argc, char **argv) {
    static const char *const kinds[] = {"spheres", "cubes", "cubes4", "cubes8", "cubes27", "cubes64", "cubes100"};
    const char *only = 0;
    int count = 500, film = 0, i, k, known = 0, wrong = 0;
    for (i = 1; i < argc; i++) {
        if (!strcmp(argv[i], "--count") && i + 1 < argc) count = atoi(argv[++i]);
        else if (!strcmp(argv[i], "--film")) film = 1;
        else only = argv[i];
    }
    for (k = 0; k < 7; k++) known |= !only || !strcmp(only, kinds[k]);
    if (!known || count < 10 || count > 5000) {
        puts("repose [spheres|cubes|cubes4|cubes8|cubes27|cubes64|cubes100] [--count 10..5000] [--film]");
        return 2;
    }
    for (k = 0; k < 7; k++) if (!only || !strcmp(only, kinds[k])) wrong |= heap(kinds[k], count, film);
    return wrong;
}
