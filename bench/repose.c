/* repose.c - angles of repose of spheres, of cubes as polyhedra and of cubes made of spheres, by springs or by
   impulses, and what each costs.

   shelf: a shelf with a wall behind, a rod half let into it along its front edge, and the next shelf beside it on
          either side (periodic) is filled behind a gate; the gate is drawn up, and what does not stay runs over the rod
          and is taken out. What stays is one slope from the wall to the rod, and neither the floor's friction nor the
          run of a falling pile decides it. Told: the straight line through the highest grains from 20 to 80 % of its
          height ("flank"), and the angle whose tangent is the height of the centre of mass above the lowest layer over
          its distance from the wall ("by the centre of mass": low, since the layer behind the rod counts, but steady).
   tube:  a tube on a floor is filled and then drawn up; told: the slope of the cone with the heap's centre of mass and
          mean distance from its axis, as in examples/heap.c, and that of its flank.

   Build:    make build/repose
   Run:      repose [KIND] [options]    KIND: spheres, cubes, cubes4, cubes8, cubes27, cubes64, cubes100; or all of them
             --heap shelf|tube            shelf
             --response impulses|springs  impulses
             --step S                     s, 5e-4 and 5e-6
             --sweeps N                   of impulses, at most: 200
             --count N                    2000 (10..5000)
             --friction MU                0.5
             --rolling MU                 rolling friction of spheres: 0.05
             --seeds N, --seed K          so many runs, from this one on: 1, 1
             --replay                     writes repose_KIND.html
   One line for each run; after more than one seed a line of means and standard errors. */
#define DEM_IMPLEMENTATION
#include "dem.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const double edge = 3e-3, degree = 3.14159265358979/180;             /* m, rad */
static struct {
    int tube, springs, count, seeds, seed, replay;
    double step, friction, rolling;
    int sweeps;
} asked = {0, 0, 2000, 1, 1, 0, 0, 0.5, 0.05, 0};
struct told { double slope, cone, error, time, overlap, unsolved, kinetic, left; };

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
/* A sheet of triangles that is drawn up at .15 m/s from a time on: a tube about the z axis, or a gate across the shelf. */
static void sheet(dem_world *world, dem_material material, int sides, double x, double half, double height, double from) {
    dem_real vertices[2*25*3];
    int32_t triangles[2*24*3];
    dem_mesh mesh = {0, 0, vertices, triangles};
    dem_motion motion = DEM_MOTION;
    const int around = sides > 1, corners = around ? sides : 2;
    int i, k;
    for (i = 0; i < corners; i++)
        for (k = 0; k < 2; k++) {
            dem_real *v = vertices + 3*(2*i + k);
            v[0] = (dem_real)(around ? x*cos(360*degree*i/sides) : x);
            v[1] = (dem_real)(around ? x*sin(360*degree*i/sides) : (2*i - 1)*half);
            v[2] = (dem_real)(k*height);
        }
    for (i = 0; i < sides; i++) {
        const int next = (i + 1)%corners, two[6] = {2*i, 2*next, 2*next + 1, 2*i, 2*next + 1, 2*i + 1};
        for (k = 0; k < 6; k++) triangles[6*i + k] = two[k];
    }
    mesh.vertex_count = 2*corners;
    mesh.triangle_count = 2*sides;
    motion.kind = DEM_MOTION_TRANSLATING;
    motion.velocity.z = DEM_R(0.15);
    motion.start = from;
    dem_wall_motion_set(world, dem_wall_mesh_add(world, material, &mesh), &motion);
}
/* The straight line through the highest grains of a slope that falls along x: mean over strips of the highest grain's
   centre in each, from 20 to 80 % of its height; its angle and what the fit leaves open, degrees. */
static double line(const dem_world *world, double length, double width, double *error) {
    enum { ROWS = 64, STRIPS = 5 };
    static double top[ROWS][STRIPS];
    const dem_bodies bodies = dem_bodies_get(world);
    double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0, high[ROWS], highest = 0, slope;
    const int rows = (int)(length/edge);
    int i, k, first = 0, last;
    memset(top, 0, sizeof top);
    for (i = 0; i < bodies.count; i++) {
        const double at = (double)bodies.positions[4*i]/edge, z = (double)bodies.positions[4*i + 2];
        const double across = (double)bodies.positions[4*i + 1]/width + 0.5;
        const int strip = (int)((across - floor(across))*STRIPS);
        if (at >= 0 && at < rows && at < ROWS) top[(int)at][strip%STRIPS] = fmax(top[(int)at][strip%STRIPS], z);
    }
    for (i = 0; i < rows && i < ROWS; i++) {
        for (high[i] = 0, k = 0; k < STRIPS; k++) high[i] += top[i][k]/STRIPS;
        highest = fmax(highest, high[i]);
    }
    for (i = 0; i < rows; i++) if (high[i] > 0.8*highest) first = i;
    for (last = first; last < rows && high[last] >= 0.2*highest; last++) {
        const double at = (last + 0.5)*edge, h = high[last];
        n++; x += at; y += h; xx += at*at; xy += at*h; yy += h*h;
    }
    *error = 90;
    if (n < 4) return 0;
    xx -= x*x/n; xy -= x*y/n; yy -= y*y/n;
    slope = xy/xx;
    *error = sqrt(fmax(yy - slope*xy, 0)/(n - 2)/xx)/(1 + slope*slope)/degree;
    return -atan(slope)/degree;
}
static int heap(const char *kind, int seed, struct told *told) {
    const int round = !strcmp(kind, "spheres"), spheres = atoi(kind + 5), count = asked.count;
    const double size = cbrt(count/2000.0), radius = 25e-3*size;            /* the tube's, m */
    const double length = 18*edge*sqrt(count/2000.0), width = 8*edge;       /* the shelf's, m */
    const double from = asked.tube ? 0.45 : 0.4;                            /* s: when it opens, and when all rests */
    const double end = from + (asked.tube ? 0.95 : 0.6 + 0.6*sqrt(count/2000.0));
    const dem_real same = (dem_real)(edge*0.6203504908994);         /* m, radius of the sphere of its volume */
    const double tall = count*pow(edge, 3)/(asked.tube ? 0.055*pow(1.36*radius, 2) : 0.09*length*width);
    const double side = asked.tube ? 0.68*radius : 0;
    const dem_box box = asked.tube
        ? dem_box_make((dem_real)-side, (dem_real)-side, DEM_R(0.004), (dem_real)side, (dem_real)side, (dem_real)tall)
        : dem_box_make(0, (dem_real)(-width/2), DEM_R(0.004), (dem_real)length, (dem_real)(width/2), (dem_real)tall);
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc gravel = DEM_MATERIAL_DESC;
    dem_replay_desc replay_desc = DEM_REPLAY_DESC;
    dem_outlet_desc over = DEM_OUTLET_DESC;
    dem_replay *replay = 0;
    dem_spheres_fit fit;
    dem_repose flank;
    dem_world *world;
    dem_material m;
    dem_shape shape = {0};
    double out = 0, high = 0, spent, inside = 0;
    char path[64];
    int i, placed;
    memset(told, 0, sizeof *told);
    desc.gravity.z = DEM_R(-9.81);
    if (asked.springs) desc.normal_law = DEM_NORMAL_LINEAR;
    else desc.response = DEM_RESPONSE_IMPULSES;
    desc.dt = (dem_real)(asked.step > 0 ? asked.step : asked.springs ? 5e-6 : 5e-4);
    desc.sweeps = asked.sweeps;
    desc.threads = 1;
    if (!asked.tube) {
        desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
        desc.domain = dem_box_make(DEM_R(-0.1), (dem_real)(-width/2), DEM_R(-0.1), DEM_R(0.5), (dem_real)(width/2), 1);
    }
    world = dem_world_create(&desc);
    gravel.density = 2500;
    gravel.stiffness = 3000;
    gravel.restitution = DEM_R(0.3);
    gravel.friction = (dem_real)asked.friction;
    if (round) gravel.rolling_friction = (dem_real)asked.rolling;
    m = dem_material_add(world, &gravel);
    dem_wall_plane_add(world, m, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
    if (asked.tube) sheet(world, m, 24, radius, 0, tall + 0.1, from);
    else {
        dem_wall_plane_add(world, m, dem_vec3_make(0, 0, 0), dem_vec3_make(1, 0, 0));
        dem_wall_cylinder_add(world, m, dem_vec3_make((dem_real)length, 0, 0), dem_vec3_make(0, 1, 0), (dem_real)edge, 0);
        sheet(world, m, 1, length + edge, width/2, tall + 0.1, from);
        over.box = dem_box_make((dem_real)(length + edge), -1, -1, 1, 1, 1);
        dem_outlet_add(world, &over);
    }
    if (!round) shape = cube(world, spheres, &fit);
    placed = round ? dem_spheres_fill(world, m, same, dem_region_make(box), count, (uint64_t)seed)
                   : dem_bodies_fill(world, m, shape, dem_region_make(box), count, (uint64_t)seed);
    snprintf(path, sizeof path, "repose_%s.html", kind);
    replay_desc.interval = 0.02;
    if (asked.replay) replay = dem_replay_open(world, path, &replay_desc);
    spent = (double)clock();
    if (placed < count || dem_world_run(world, end, 0, 0) != DEM_OK) {
        printf("%s, seed %d, %g s: %s\n", kind, seed, dem_world_time_get(world), dem_world_error_get(world));
        fflush(stdout);
        if (replay) dem_replay_close(replay);
        dem_world_destroy(world);
        return 1;
    }
    told->time = ((double)clock() - spent)/CLOCKS_PER_SEC/end;
    if (replay) dem_replay_close(replay);
    for (i = 0; i < dem_bodies_get(world).count; i++) {
        const dem_real *x = dem_bodies_get(world).positions + 4*i;
        const double r = asked.tube ? sqrt((double)(x[0]*x[0] + x[1]*x[1])) : (double)x[0];
        if (r > (asked.tube ? 4.8*radius : length + edge)) continue;
        out += r;
        high += (double)x[2];
        inside++;
    }
    /* a cone: height 4 times that of its centre of mass, radius 3/2 of the mean distance; a wedge: both 3 times */
    told->cone = atan((asked.tube ? 2 : 1)*(high/inside - (double)same)/(out/inside))/degree;
    if (!asked.tube) told->slope = line(world, length, width, &told->error);
    else if (dem_repose_heap_get(world, (dem_box){{0, 0, 0}, {0, 0, 0}}, &flank) == DEM_OK) {
        told->slope = flank.angle/degree;
        told->error = flank.error/degree;
    }
    told->left = inside;
    told->kinetic = (dem_totals_get(world).kinetic + dem_totals_get(world).rotational)/dem_totals_get(world).mass;
    told->overlap = (double)dem_counters_get(world).overlap_max;
    told->unsolved = (double)dem_counters_get(world).unsolved/(double)dem_counters_get(world).steps;
    printf("%-9s seed %d: flank %.1f +- %.1f, by the centre of mass %.1f degrees; %.0f grains; %.1f s/s; kinetic %.1e "
           "J/kg; overlap %.3f, %.2f of the steps unsolved", kind, seed, told->slope, told->error, told->cone, told->left,
           told->time, told->kinetic, told->overlap, told->unsolved);
    if (spheres && seed == asked.seed) printf("; wrong volume %.3f", (double)fit.wrong);
    puts("");
    fflush(stdout);
    dem_world_destroy(world);
    return 0;
}
/* Mean and standard error of a row of results. */
static void mean(const char *name, const double *first, int count) {
    const int step = (int)(sizeof(struct told)/sizeof(double));
    double sum = 0, squares = 0;
    int i;
    for (i = 0; i < count; i++) sum += first[i*step];
    for (i = 0; i < count; i++) squares += pow(first[i*step] - sum/count, 2);
    printf(" %s %.2f +- %.2f", name, sum/count, count > 1 ? sqrt(squares/(count - 1)/count) : 0.0);
}
int main(int argc, char **argv) {
    static const char *const kinds[] = {"spheres", "cubes", "cubes4", "cubes8", "cubes27", "cubes64", "cubes100"};
    static struct told told[100];
    const char *only = 0;
    int i, k, seed, good, known = 0, wrong = 0;
    for (i = 1; i < argc; i++) {
        const char *option = argv[i], *value = i + 1 < argc ? argv[i + 1] : "";
        if (!strcmp(option, "--replay")) { asked.replay = 1; continue; }
        if (strncmp(option, "--", 2)) { only = option; continue; }
        i++;
        if (!strcmp(option, "--count")) asked.count = atoi(value);
        else if (!strcmp(option, "--seeds")) asked.seeds = atoi(value);
        else if (!strcmp(option, "--seed")) asked.seed = atoi(value);
        else if (!strcmp(option, "--step")) asked.step = atof(value);
        else if (!strcmp(option, "--sweeps")) asked.sweeps = atoi(value);
        else if (!strcmp(option, "--friction")) asked.friction = atof(value);
        else if (!strcmp(option, "--rolling")) asked.rolling = atof(value);
        else if (!strcmp(option, "--heap") && (!strcmp(value, "tube") || !strcmp(value, "shelf")))
            asked.tube = !strcmp(value, "tube");
        else if (!strcmp(option, "--response") && (!strcmp(value, "springs") || !strcmp(value, "impulses")))
            asked.springs = !strcmp(value, "springs");
        else wrong = 1;
    }
    for (k = 0; k < 7; k++) known |= !only || !strcmp(only, kinds[k]);
    if (wrong || !known || asked.count < 10 || asked.count > 5000 || asked.seeds < 1 || asked.seeds > 100) {
        puts("repose [spheres|cubes|cubes4|cubes8|cubes27|cubes64|cubes100] [--heap shelf|tube] [--response impulses|springs]\n"
             "       [--step S] [--sweeps N] [--count 10..5000] [--friction MU] [--rolling MU] [--seeds 1..100] [--seed K] [--replay]");
        return strcmp(argv[argc - 1], "--help") ? 2 : 0;
    }
    for (k = 0; k < 7; k++) {
        if (only && strcmp(only, kinds[k])) continue;
        for (good = 0, seed = 0; seed < asked.seeds; seed++)
            if (!heap(kinds[k], asked.seed + seed, &told[good])) good++; else wrong = 1;
        if (good < 2) continue;
        printf("%s, %d seeds, friction %g:", kinds[k], good, asked.friction);
        mean("flank", &told->slope, good);
        mean("centre", &told->cone, good);
        mean("time", &told->time, good);
        mean("grains", &told->left, good);
        puts("");
        fflush(stdout);
    }
    return wrong;
}
