/* 03_incline.c - a ball on an inclined plane rolls while friction holds it, and slides when it does not.

   A homogeneous ball rolls without sliding as long as tan(angle) <= 7/2 mu, and then
       a = 5/7 g sin(angle);
   beyond that the contact slides and
       a = g (sin(angle) - mu cos(angle)),  R dw/dt = 5/2 mu g cos(angle).
   mu = .2: the border is at 34.99 degrees. Instead of tilting the plane we tilt gravity.

   Build:     cc -O2 03_incline.c ../dem.c -lm
   Expected:  accelerations within .1 %, slip only at 40 and 50 degrees */
#include "../dem.h"
#include <math.h>

int main(void) {
    const double g = 9.81, mu = 0.2, radius = 0.01, pi = 3.14159265358979324;
    int wrong = 0;
    printf("angle  a [m/s2]  expected  R dw/dt  expected  contact\n");
    for (int angle = 10; angle <= 50; angle += 10) {
        double s = sin(angle*pi/180), c = cos(angle*pi/180);
        dem_world_desc desc = DEM_WORLD_DESC;
        desc.gravity = dem_vec3_make(g*s, 0, -g*c);                 /* m/s2 */
        dem_world *world = dem_world_create(&desc);

        dem_material_desc steel_desc = DEM_MATERIAL_DESC;
        steel_desc.density = 7800;                                  /* kg/m3 */
        steel_desc.young = 1e9;                                     /* Pa, softened */
        steel_desc.poisson = 0.3;
        steel_desc.restitution = 0.3;
        steel_desc.friction = mu;
        dem_material steel = dem_material_add(world, &steel_desc);
        dem_plane_add(world, steel, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
        dem_body ball = dem_sphere_add(world, steel, radius, dem_vec3_make(0, 0, radius));

        /* let it settle onto the plane, then measure over half a second */
        dem_body_state from, to;
        dem_check_print(world, stdout);
        if (dem_world_run(world, 0.1, 0, 0) != DEM_OK) { puts(dem_world_error(world)); return 1; }
        double start = dem_world_time(world);
        dem_body_get(world, ball, &from);
        if (dem_world_run(world, 0.5, 0, 0) != DEM_OK) { puts(dem_world_error(world)); return 1; }
        double time = dem_world_time(world) - start;
        dem_body_get(world, ball, &to);
        double a = (to.velocity.x - from.velocity.x)/time;
        double rw = radius*(to.spin.y - from.spin.y)/time;

        int rolls = s/c <= 3.5*mu;
        double a_expected = rolls ? 5*g*s/7 : g*(s - mu*c);
        double rw_expected = rolls ? a_expected : 2.5*mu*g*c;
        printf("%5d  %8.4f  %8.4f  %7.4f  %8.4f  %s\n", angle, a, a_expected, rw, rw_expected,
               rolls ? "rolls" : "slides");
        wrong += !(fabs(a/a_expected - 1) < 1e-3 && fabs(rw/rw_expected - 1) < 1e-3);
        dem_world_destroy(world);
    }
    return wrong > 0;
}
