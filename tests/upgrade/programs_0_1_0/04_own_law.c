/* 04_own_law.c - a contact law of your own: a spring that is stiffer on the way out than on the way in.

   Hysteretic spring after Walton & Braun, J. Rheol. 30 (1986) 949: loading F = k1 d, unloading
   F = k2 (d - d0) from the largest overlap dmax reached, so that d0 = (1 - k1/k2) dmax stays as a dent.
   The work that does not come back gives a restitution that no speed changes:
       e = sqrt(k1/k2)
   The law sees one contact, remembers one number (dmax), and answers with a force.

   Build:     cc -O2 04_own_law.c -lm
              (docs/extending.md tells how to have the law compiled into the loop)
   Expected:  e within .2 % for four ratios and two speeds */
#define DEM_IMPLEMENTATION
#include "../dem.h"
#include <math.h>

typedef struct springs { double k1, k2; } springs;                  /* N/m */

static void hysteretic(const dem_contact *c, dem_real *memory, dem_push *push) {
    const springs *k = (const springs *)c->user;
    dem_real dmax = memory[0] > c->overlap ? memory[0] : c->overlap;    /* m */
    dem_real loading = k->k1*c->overlap;
    dem_real unloading = k->k2*(c->overlap - (1 - k->k1/k->k2)*dmax);
    push->normal = unloading < loading ? unloading : loading;
    if (push->normal < 0) push->normal = 0;                         /* inside the dent: nothing */
    if (c->dt > 0) memory[0] = dmax;                                /* dt = 0: only asked, not run */
}

int main(void) {
    const double ratios[] = {1, 2, 4, 10}, speeds[] = {0.1, 1};     /* k2/k1, m/s */
    const double radius = 0.005;                                    /* m */
    int wrong = 0;
    printf("k2/k1  speed [m/s]  restitution  expected\n");
    for (int i = 0; i < 8; i++) {
        springs k;
        k.k1 = 1e4;
        k.k2 = ratios[i/2]*k.k1;
        double speed = speeds[i%2];

        dem_world_desc desc = DEM_WORLD_DESC;
        desc.law = hysteretic;
        desc.law_user = &k;
        desc.law_memory = 1;
        desc.law_stiffness = k.k2;                                  /* what the time step must resolve */
        dem_world *world = dem_world_create(&desc);
        dem_material_desc clay_desc = DEM_MATERIAL_DESC;
        clay_desc.density = 2000;                                   /* kg/m3 */
        clay_desc.young = 1e7;                                      /* required, though our law looks away */
        clay_desc.restitution = 1;
        dem_material clay = dem_material_add(world, &clay_desc);

        /* two equal grains meet head-on */
        dem_body_state state;
        dem_body left = dem_sphere_add(world, clay, radius, dem_vec3_make(-1.01*radius, 0, 0));
        dem_body right = dem_sphere_add(world, clay, radius, dem_vec3_make(1.01*radius, 0, 0));
        dem_body_get(world, left, &state);
        state.velocity.x = speed/2;
        dem_body_set(world, left, &state);
        dem_body_get(world, right, &state);
        state.velocity.x = -speed/2;
        dem_body_set(world, right, &state);

        if (dem_world_run(world, 0.1*radius/speed + 5e-3, 0, 0) != DEM_OK) {
            puts(dem_world_error(world));
            return 1;
        }
        dem_body_get(world, right, &state);
        double e = 2*state.velocity.x/speed, expected = sqrt(k.k1/k.k2);
        printf("%5.0f  %11.1f  %11.5f  %8.5f\n", ratios[i/2], speed, e, expected);
        wrong += !(fabs(e/expected - 1) < 2e-3);
        dem_world_destroy(world);
    }
    return wrong > 0;
}
