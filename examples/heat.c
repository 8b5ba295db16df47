/* heat.c - heat conduction through a bed of steel balls.

   The floor is kept at 400 K, the uppermost balls at 300 K. Heat flows through contacts: 2 k a dT through a disc of radius
   a = sqrt(R* d), where d is the overlap of Hertz's law. examples/laws/heat.h is the law, with source and limits. Each ball
   carries its temperature as a user-defined number (body_reals). The law sees both temperatures of a contact and adds the
   rates of change; dem.h sums and integrates them.

   Real balls of 5 mm warm up within minutes, and a step lasts some microseconds. But the bed is at rest, and the final flow of
   heat does not depend on the heat capacity. The capacity is therefore made small, and the steady state comes within a second.

   Question:  Eight times the weight presses each contact with eight times the force. How much more heat flows? (d is
              proportional to F^(2/3).) And through balls that are ten times as stiff?
   Build:     cc -O2 -o heat heat.c ../dem.c -lm      (in the folder examples)
   Output:    under 8 g 2.0 to 2.6 times the heat: larger discs give the factor 2, new contacts the rest. With ten times the
              modulus 0.40 to 0.50 times the heat (10^(-1/3) = 0.46). The heat flows at floor and top agree within 1 %.
              heat.vtp is for ParaView: colour by temperature. About 10 s on one core
   Exercises: Cool the floor to 300 K in the steady state. After which time has half of the excess heat left the bed? For which
              capacity do the temperatures oscillate from step to step, and why? (heat.h has the limit of Euler's step.) */
#include "../dem.h"
#include "laws/heat.h"

static const double R = 2.5e-3;                                     /* m */

/* Integrates the temperature of balls below a height; balls above it keep theirs (cooled). */
static void follow(dem_real *reals, const dem_real *rates, const dem_body_state *body, dem_body id, double time, dem_real dt,
                   void *user) {
    const double *height = (const double *)user;
    (void)id; (void)time;
    if ((double)body->position.z < *height) reals[0] += rates[0]*dt;
}

/* Returns the heat flow (W) from the floor into a bed with this modulus (Pa) under g (m/s2), and writes the heat flow into the
   cooled balls to *top. Returns -1 if the run failed. */
static double heat_through(double young, double g, const char *picture, double *top) {
    static const dem_real conductivity[] = {16}, capacity[] = {DEM_R(0.02)};    /* W/(m K); J/(kg K): of steel 500 */
    heat steel_heat = {conductivity, capacity, 0, 0};
    double height = 1e30, given;
    dem_world_desc desc = DEM_WORLD_DESC;
    const dem_real warm = 400, cold = 300;
    desc.gravity.z = (dem_real)-g;
    desc.boundary[0] = desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
    desc.domain = dem_box_make(0, 0, -1, (dem_real)(8*R), (dem_real)(8*R), 1);
    desc.law = heat_law;
    desc.law_user = &steel_heat;
    desc.law_memory = 4;
    desc.law_vectors = 1;
    desc.law_who = 1;
    desc.law_rate = heat_rate;
    desc.body_reals = "temperature";
    desc.body_reals_fn = follow;
    desc.body_reals_user = &height;
    dem_world *world = dem_world_create(&desc);

    dem_material_desc steel_desc = DEM_MATERIAL_DESC;
    steel_desc.density = 7800;
    steel_desc.young = (dem_real)young;
    steel_desc.poisson = 0.28;
    steel_desc.restitution = 0.3;
    steel_desc.friction = 0.3;
    dem_material steel = dem_material_add(world, &steel_desc);
    dem_wall floor = dem_wall_plane_add(world, steel, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
    dem_wall_reals_set(world, floor, &warm);
    dem_spheres_fill(world, steel, (dem_real)R,
                     dem_region_make(dem_box_make(0, 0, 0, (dem_real)(8*R), (dem_real)(8*R), (dem_real)(40*R))),
                     150, 1);
    dem_bodies balls = dem_bodies_get(world);
    for (int i = 0; i < balls.count; i++) dem_body_reals_set(world, dem_body_id_get(world, i), &cold);

    if (dem_world_run(world, 0.35, 0, 0) != DEM_OK) { puts(dem_world_error_get(world)); return -1; }
    balls = dem_bodies_get(world);
    for (int i = 0; i < balls.count; i++)
        if (i == 0 || (double)balls.positions[4*i + 2] > height + 2*R) height = (double)balls.positions[4*i + 2] - 2*R;
    for (int i = 0; i < balls.count; i++)                           /* removes the heat of the filling */
        dem_body_reals_set(world, dem_body_id_get(world, i), &cold);
    if (dem_world_run(world, 0.4, 0, 0) != DEM_OK) { puts(dem_world_error_get(world)); return -1; }

    dem_wall_loads loads;
    dem_wall_loads_get(world, floor, &loads);
    given = -loads.rate[0];
    balls = dem_bodies_get(world);
    *top = 0;
    for (int i = 0; i < balls.count; i++)
        if (!((double)balls.positions[4*i + 2] < height))
            *top += (double)(balls.rates[i]*balls.masses[i]*capacity[0]);
    if (picture && dem_vtp_write(world, picture) != DEM_OK) puts(dem_world_error_get(world));
    dem_world_destroy(world);
    return given;
}

int main(void) {
    static const struct { const char *what; double young, g, least, most; } rows[] = {
        {"5 MPa, 1 g", 5e6, 9.81, 1, 1}, {"5 MPa, 8 g", 5e6, 8*9.81, 2, 2.6}, {"50 MPa, 1 g", 5e7, 9.81, 0.4, 0.5}};
    double first = 0, top;
    int k, wrong = 0;
    printf("%-16s %12s %14s %8s\n", "", "from floor", "into top", "ratio");
    for (k = 0; k < 3; k++) {
        const double Q = heat_through(rows[k].young, rows[k].g, k ? 0 : "heat.vtp", &top);
        if (!k) first = Q;
        printf("%-16s %10.4f W %12.4f W %8.2f\n", rows[k].what, Q, top, Q/first);
        wrong += !(Q > 0) || Q/first < rows[k].least || Q/first > rows[k].most || !(fabs(top/Q - 1) < 0.01);
    }
    return wrong;
}
