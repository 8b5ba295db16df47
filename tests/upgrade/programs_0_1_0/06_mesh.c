/* 06_mesh.c - a ball rolls over a floor of triangles and must not notice where they meet.

   The floor is an OBJ file held in memory: 3 x 3 corners, 8 triangles. The ball crosses an edge, the
   corner in the middle and another edge. In a second world the floor is a plane: equal paths, please.
   A mesh is looked over when read: its open edges, duplicates, slivers and a likely mistake in units are
   told, and never stop a run.

   Build:     cc -O2 06_mesh.c -lm
   Expected:  both balls at the same place to 1e-9 m, 8 open edges (the border of the floor);
              floor.vtp opens in ParaView */
#define DEM_IMPLEMENTATION
#include "../dem.h"
#include <math.h>
#include <string.h>

static const char floor_obj[] =
    "v 0 -1 0\nv 1 -1 0\nv 2 -1 0\n"
    "v 0  0 0\nv 1  0 0\nv 2  0 0\n"
    "v 0  1 0\nv 1  1 0\nv 2  1 0\n"
    "f 1 2 4\nf 2 5 4\nf 2 3 6\nf 2 6 5\nf 4 5 8\nf 4 8 7\nf 5 6 8\nf 6 9 8\n";

int main(void) {
    const double radius = 0.1;                                      /* m */
    dem_world *worlds[2];
    dem_body balls[2];
    dem_body_state state;
    int open_edges = -1;
    for (int i = 0; i < 2; i++) {
        dem_world_desc desc = DEM_WORLD_DESC;
        desc.gravity.z = -9.81;                                     /* m/s2 */
        dem_world *world = worlds[i] = dem_world_create(&desc);
        dem_material_desc oak_desc = DEM_MATERIAL_DESC;
        oak_desc.density = 700;                                     /* kg/m3 */
        oak_desc.young = 1e8;                                       /* Pa */
        oak_desc.poisson = 0.3;
        oak_desc.restitution = 0.5;
        oak_desc.friction = 0.4;
        dem_material oak = dem_material_add(world, &oak_desc);

        if (i == 0) {
            dem_mesh mesh;
            dem_mesh_health health;
            if (dem_mesh_parse(world, "floor.obj", floor_obj, strlen(floor_obj), &mesh, &health) != DEM_OK) {
                puts(dem_world_error(world));
                return 1;
            }
            open_edges = health.open_edges;
            printf("%d corners, %d triangles: %d open edges, %d duplicates, %d slivers %s\n", mesh.vertex_count,
                   mesh.triangle_count, health.open_edges, health.duplicates, health.slivers, health.hint);
            dem_mesh_add(world, oak, &mesh);                        /* the world keeps a copy */
            dem_mesh_free(world, &mesh);
        } else {
            dem_plane_add(world, oak, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
        }

        /* it starts a little above the floor, with a push and no spin: it bounces, slides, then rolls */
        balls[i] = dem_sphere_add(world, oak, radius, dem_vec3_make(1.95, 0.19, radius + 0.001));
        dem_body_get(world, balls[i], &state);
        state.velocity = dem_vec3_make(-2.5, -0.5, 0);                /* m/s */
        dem_body_set(world, balls[i], &state);
    }

    double worst = 0;
    printf("time [s]      x [m]      y [m]      z [m]  from the plane's [m]\n");
    for (int n = 1; n <= 10; n++) {
        dem_vec3 at[2];
        for (int i = 0; i < 2; i++) {
            if (dem_world_run(worlds[i], 0.1, 0, 0) != DEM_OK) { puts(dem_world_error(worlds[i])); return 1; }
            dem_body_get(worlds[i], balls[i], &state);
            at[i] = state.position;
        }
        double off = sqrt(pow(at[0].x - at[1].x, 2) + pow(at[0].y - at[1].y, 2) + pow(at[0].z - at[1].z, 2));
        printf("%8.1f  %9.6f  %9.6f  %9.6f  %20.3g\n", dem_world_time(worlds[0]), at[0].x, at[0].y, at[0].z, off);
        if (!(off <= worst)) worst = off;
    }
    if (dem_walls_vtp_write(worlds[0], "floor.vtp", 0, 0) != DEM_OK) { puts(dem_world_error(worlds[0])); return 1; }
    for (int i = 0; i < 2; i++) dem_world_destroy(worlds[i]);
    return !(worst < 1e-9) || open_edges != 8;
}
