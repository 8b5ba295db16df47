/* 06_hopper.c - lesson 6: a hopper. You learn: flow through a hole (Beverloo), scaling laws, outlets.

   Build:     cc -O2 -o 06_hopper 06_hopper.c ../dem.c -lm      (in the folder examples)
   Run:       ./06_hopper or, with a replay of the middle hole and its flow, ./06_hopper --replay
   Question:  Water flows out with the speed sqrt(2 g h), so it becomes slower and slower. Does sand? Is the flow
              doubled if the hole is twice as wide? Write down both answers, then run. */
#include "../dem.h"
#include "lesson.h"

enum { COUNT = 480, SEEDS = 2, HOLES = 3 };
static const double R = 2.5e-3, half = 0.045, thickness = 5e-3, g = 9.81;   /* m, half the hopper's width; m/s2 */

typedef struct outflow { double rate, evenness, bulk, overlap; } outflow;   /* kg/s; -; kg/m3; radii */

/* Fills the hopper, opens it, and finds when 10, 30, 50 and 70 % of the discs have left. Returns 1 on failure. */
static int run_out(double hole, int seed, int record, outflow *f) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.planar = 1;
    desc.thickness = thickness;
    desc.gravity.y = -g;
    desc.dt = 1.4e-5;                                               /* s, t_c/22; 0 would choose a shorter step */
    dem_world *world = dem_world_create(&desc);
    dem_material_desc bead_desc = DEM_MATERIAL_DESC;
    bead_desc.density = 2500;                                       /* kg/m3 */
    bead_desc.young = 2.5e7;                                        /* Pa, softened */
    bead_desc.poisson = 0.25;
    bead_desc.restitution = 0.5;
    bead_desc.friction = 0.4;
    dem_material bead = dem_material_add(world, &bead_desc);

    dem_real x = half, b = hole/2, corners[] = {-x, 0.25, -x, 0, -b, 0, b, 0, x, 0, x, 0.25};
    int32_t sides[] = {0, 1, 1, 2, 3, 4, 4, 5}, across[] = {2, 3};    /* from corner to corner */
    dem_profile hopper = {6, 4, corners, sides}, lid = {6, 1, corners, across}; /* 6 corners; 4 sides, 1 side */
    dem_wall_profile_add(world, bead, &hopper, DEM_EDGE_RESOLVED);
    dem_wall closed = dem_wall_profile_add(world, bead, &lid, DEM_EDGE_RESOLVED);
    for (int i = 0; i < 2; i++)                                     /* two sizes, against regular packing */
        dem_spheres_fill(world, bead, (0.95 + 0.1*i)*R,
                         dem_region_make(dem_box_make(-x, 0, 0, x, 0.24, 0)), COUNT/2,
                         (uint64_t)(2*seed + i));
    dem_outlet_desc below = DEM_OUTLET_DESC;                        /* removes discs below the hole and counts them */
    below.box = dem_box_make(-x, -0.2, -1, x, -0.02, 1);
    dem_outlet out = dem_outlet_add(world, &below);

    if (dem_world_run(world, 0.3, 0, 0) != DEM_OK) { puts(dem_world_error_get(world)); return 1; }
    dem_totals full = dem_totals_get(world);
    f->bulk = full.mass/(4*half*full.centre[1])/thickness;          /* height: twice that of the centre of mass */
    dem_wall_remove(world, closed);
    dem_overlap_max_reset(world);
    dem_replay_desc replay_desc = DEM_REPLAY_DESC;
    replay_desc.interval = 0.01;                                    /* s */
    dem_replay *replay = record ? dem_replay_open(world, "06_hopper.html", &replay_desc) : 0;
    dem_outlet_state gone;
    double begun = dem_world_time_get(world), mark[4] = {0, 0, 0, 0}, mass[4] = {0, 0, 0, 0};
    for (int stage = 0; stage < 4 && dem_world_time_get(world) < begun + 5;) {
        if (dem_world_run(world, 0.01, 0, 0) != DEM_OK) { puts(dem_world_error_get(world)); return 1; }
        dem_outlet_get(world, out, &gone);
        dem_replay_value_set(replay, "discharged mass (kg)", gone.total_mass);
        if ((int)gone.total >= COUNT*(1 + 2*stage)/10) {            /* 10, 30, 50, 70 % of the discs are out */
            mark[stage] = dem_world_time_get(world);
            mass[stage++] = gone.total_mass;
        }
    }
    f->overlap = dem_counters_get(world).overlap_max;
    dem_replay_close(replay);
    dem_world_destroy(world);
    f->evenness = (mass[3] - mass[2])/(mark[3] - mark[2])/((mass[1] - mass[0])/(mark[1] - mark[0]));
    f->rate = (mass[2] - mass[0])/(mark[2] - mark[0]);
    return 0;
}

int main(int argc, char **argv) {
    const int record = lesson_begin(argc, argv, "06_hopper");
    const double d = 2*R, k = 1.4, holes[HOLES] = {6*d, 7.5*d, 9*d};  /* m, -, m */
    double rate[HOLES], error[HOLES], C[HOLES], even[HOLES*SEEDS], bar, overlap = 0;
    puts("hole/d     flow [kg/s]           C   flow half empty/full");
    for (int i = 0; i < HOLES; i++) {
        double w[SEEDS], rho_b = 0;
        for (int seed = 0; seed < SEEDS; seed++) {
            outflow f;
            if (run_out(holes[i], seed + 1, record && i == 1 && !seed, &f)) return 1;
            w[seed] = f.rate;
            even[i*SEEDS + seed] = f.evenness;
            rho_b += f.bulk/(double)SEEDS;
            overlap = fmax(overlap, f.overlap);
        }
        rate[i] = lesson_mean(w, SEEDS, &error[i]);
        C[i] = rate[i]/(rho_b*thickness*sqrt(g)*pow(holes[i] - k*d, 1.5));
        printf("%6.1f  %8.4f +- %.4f  %8.2f  %8.2f\n", holes[i]/d, rate[i], error[i], C[i],
               lesson_mean(even + i*SEEDS, SEEDS, &bar));
    }
    const double span = log((holes[2] - k*d)/(holes[0] - k*d)), c = lesson_mean(C, HOLES, &bar);
    const double misfit = hypot(error[0]/rate[0], error[2]/rate[2])/span;
    lesson_row("exponent of (B - 1.4 d)", log(rate[2]/rate[0])/span, misfit, 1.5, 15);
    lesson_range("C, mean of the three holes", c, bar, 0.7, 1.2);
    const double steady = lesson_mean(even, HOLES*SEEDS, &bar);     /* water: sqrt(0.4/0.8) = 0.71 */
    lesson_range("flow when half empty over flow when full", steady, bar, 0.8, 1.1);
    lesson_range("largest overlap [radii]", overlap, 0, 0, 0.06);
    return lesson_end();
}

/* STOP: answer the question before you read on.
   Theory:    Beverloo 1961. Grains fall freely below an arch over the hole, independent of the load above. In a plane
              a hole of width B then passes a flow proportional to B sqrt(g B). Grains of diameter d cannot use its
              rims, which together are k d wide, with k about 1.4:
                  W = C rho_b sqrt(g) (B - k d)^(3/2)       per depth; rho_b: bulk density
              For a round hole in three dimensions the exponent is 5/2, and C is about 0.58.
   Output:    flows through three holes. With k = 1.4 the exponent is 1.5 within 15 %, and C of discs is 0.7 to 1.2. A
              hopper that is half empty flows at 0.8 to 1.1 of its first rate; water would flow at 0.71 */
/* Exercises for ./06_hopper --check N VALUE. {2: 1 to 3 by 0.1} is 2 or, for --seed NAME, in that range. */
const char *const exercises[2] = {
    "In this plane, with k = 1.4: by which factor is the flow through a hole of {16: 12 to 24 by 1} d larger than "
    "through one of {8: 6 to 10 by 0.5} d?",
    "Round hole of {20: 15 to 40 by 1} mm, grains of {2: 1 to 2.5 by 0.1} mm, rho_b = {1500: 1300 to 1700 by 50} "
    "kg/m3, C = 0.58, k = 1.4. What is the flow in kg/s?"};
/* Marking. Stop here if you want to find the answers yourself. */
double answer(int exercise, const double *x) {
    if (exercise == 1) return pow((x[0] - 1.4)/(x[1] - 1.4), 1.5);
    return 0.58*x[2]*sqrt(g)*pow(1e-3*(x[0] - 1.4*x[1]), 2.5);      /* mm to m */
}
