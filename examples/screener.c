/* screener.c - a tumbling screening machine: five decks, four sieves, balls of five sizes.

   The machine is that of [FEN] (section 4.4), a thesis on contacts in a tumbling screening machine:
   a barrel of radius 80 cm that tumbles at 50 turns a minute, plate inclined by 1 and .65 degrees,
   sieves with square holes of half width w = 17, 15, 13, 11 mm and bars g = w between them, 3483
   balls of radius 10 to 18 mm fed at 147 a second. Every deck lets its own size out at the rim; what
   leaves with it and is smaller is gangue. --machine glass is its other example: R = 30 cm, one
   sieve (w = 1.575 mm, g = .8 mm), glass balls of 3 and 4 mm.

   What the thesis does not print is our choice, an option, and part of --study choices:
     density 2500 kg/m3, stiffness and restitution (it prints none for this machine): a linear spring
     and dashpot; softened, t_c is about 1.6 ms (large machine)
     friction .2 between balls and with the machine (glass: .06 with the machine, its optimum). Its friction on a sieve (eq 4.27 to 4.30) looks
     at the ball's velocity without its spin: balls slide. On reduced holes, which are a plane, a
     rolling friction of 1 does that here; free balls would roll, and a ball that rolls on a turning
     plate is not flung out but runs in circles. Wires and plates brake rolling by themselves
     decks .15 m (.03 m) apart; all of the rim is open (--open, --openings and --vane: a rim with
     openings, and deflectors that lead to them)
     eccentricity 40 mm where the figure does not say (4.15, 4.19, 4.21), u = e = 0
     fed from a disc of .1 m in the middle, above the first sieve

   build:  cc -O2 -std=c99 examples/screener.c -o build/screener -lm
   run:    build/screener, build/screener --study speed, build/screener --help

   Results, of one run (a sweep prints one such block per value, prefixed: rpm50.efficiency_number):
     efficiency_number, efficiency_mass   %, eq 4.33 and 4.35: mean over decks of sorted/all that left
     deckN.sorted, deckN.gangue           balls that left deck N, 1 the lowest
     gangue_number, gangue_mass           %, of all that left, eq 4.41
     fed, present, left, missing          balls; missing = fed - present - left is 0
     rate                                 balls/s that left, over the last third
     blinded                              stuck in holes at the end (never with reduced holes)
     overlap                              largest over radius
     compute                              s of wall time */
#define DEM_IMPLEMENTATION
#include "../dem.h"
#include "tumbler.h"
#include "study.h"

#define PI 3.14159265358979323846
enum { LEVELS = 5, SAMPLES = 200 };

static struct screener_options {
    double rpm, alpha, beta, eccentricity, factor, period, friction, wall_friction, zeta, rate;
    double seconds, stiffness, restitution, spacing, open, vane, steps, orifice, rolling, share;
    const char *machine, *holes, *feed, *barrel, *study, *out;
    int openings, threads, frames, balls;
} options = {0, -1, -1, 40, 1, 0, 0.2, -1, -1, 0, 0, 0, 0.5, 0, 1, -1, 22, 0.08, -1, 1,
             "large", "model2", "rate", "uniform", "run", "build/out/screener", 6, 1, 0, 0};

static const study_option table[] = {
    {"machine", STUDY_CHOICE, &options.machine, 0, 0, "large|glass", "which example"},
    {"holes", STUDY_CHOICE, &options.holes, 0, 0, "model1|model2|wires|plate", "of the sieves"},
    {"zeta", STUDY_REAL, &options.zeta, -1, 1, "",
        "clearance of reduced holes; -1: .8 (large), .6 (glass)"},
    {"rpm", STUDY_REAL, &options.rpm, 0, 1000, "1/min", "machine; 0: 50 (large), 180 (glass)"},
    {"alpha", STUDY_REAL, &options.alpha, -1, 20, "deg", "inclination; -1: 1 (large), .6 (glass)"},
    {"beta", STUDY_REAL, &options.beta, -1, 20, "deg", "inclination; -1: .65 (large), .5 (glass)"},
    {"eccentricity", STUDY_REAL, &options.eccentricity, 0, 1000, "mm", "of the shafts"},
    {"factor", STUDY_REAL, &options.factor, 0, 5, "", "K: barrel over machine; 1 free, 0 held"},
    {"period", STUDY_REAL, &options.period, 0, 10, "s", "of the barrel's swing; 0: it goes on"},
    {"friction", STUDY_REAL, &options.friction, 0, 5, "", "between balls"},
    {"wall-friction", STUDY_REAL, &options.wall_friction, -1, 5, "",
        "with the machine; -1: the same (large), .06 (glass)"},
    {"rolling", STUDY_REAL, &options.rolling, -1, 5, "",
        "rolling friction with the machine; -1: 1 on reduced holes (balls slide), else 0"},
    {"feed", STUDY_CHOICE, &options.feed, 0, 0, "rate|batch|hopper", "how balls come"},
    {"rate", STUDY_REAL, &options.rate, 0, 1e5, "1/s", "feed; 0: 147 (large), 357 (glass)"},
    {"orifice", STUDY_REAL, &options.orifice, 0.01, 1, "m", "radius of the hopper's"},
    {"balls", STUDY_INT, &options.balls, 0, 1000000, "",
        "glass: how many; 0: 775, of which 389 are small"},
    {"seconds", STUDY_REAL, &options.seconds, 0, 1e5, "s", "of machine time; 0: 25 (large), 20"},
    {"share", STUDY_REAL, &options.share, 0.001, 1, "", "of the balls and of their rate: for trying"},
    {"barrel", STUDY_CHOICE, &options.barrel, 0, 0, "uniform|stepped",
        "stepped: narrower below, by 15 % in all"},
    {"spacing", STUDY_REAL, &options.spacing, 0, 1, "m", "of decks; 0: .15 (large), .03 (glass)"},
    {"openings", STUDY_INT, &options.openings, 1, 12, "", "in the rim of each deck"},
    {"open", STUDY_REAL, &options.open, 0.01, 1, "", "share of the rim that is open"},
    {"vane", STUDY_REAL, &options.vane, -1, 0.5, "m", "deflector at each opening; -1: R/8"},
    {"stiffness", STUDY_REAL, &options.stiffness, 0, 1e9, "N/m", "0: 2e4 (large), 200 (glass)"},
    {"restitution", STUDY_REAL, &options.restitution, 0.01, 1, "", "of balls and machine"},
    {"steps", STUDY_REAL, &options.steps, 20, 1000, "", "time steps in the shortest contact"},
    {"threads", STUDY_INT, &options.threads, 0, 64, "", "0: as many as there are"},
    {"frames", STUDY_INT, &options.frames, 0, 100000, "", "VTP files of the balls over the run"},
    {"out", STUDY_TEXT, &options.out, 0, 0, "", "folder for results"},
    {"study", STUDY_CHOICE, &options.study, 0, 0,
        "run|speed|feed|inclination|eccentricity|oscillation|friction|size|holes|choices|check",
        "what to run"},
};

typedef struct screener {
    struct screener_options o;
    dem_world *world;
    tumbler machine;
    tumbler_part part[LEVELS + 1];     /* floor, sieves from below, rim */
    dem_wall floor, sieve[LEVELS], rim;
    dem_feed feed;
    dem_outlet outlet[LEVELS];
    int levels, classes, samples;
    double R, w[LEVELS], bar[LEVELS], radius[LEVELS], number[LEVELS], dt;
    double time[SAMPLES], efficiency[SAMPLES], mass_efficiency[SAMPLES], gangue[SAMPLES];
    double left[SAMPLES], present[SAMPLES], fed[SAMPLES];
    double compute;
} screener;

static int is(const char *a, const char *b) { return !strcmp(a, b); }
static int refused(dem_world *world, dem_result result) {
    if (result != DEM_OK) study_fail("%s", dem_world_error(world));
    return result != DEM_OK;
}

/* Fills in what the machine chosen prints, and our choices for the rest. */
static void screener_settle(screener *s) {
    static const double radius[5] = {0.010, 0.012, 0.014, 0.016, 0.018};
    static const double number[5] = {1210, 832, 611, 467, 363}, w[4] = {0.011, 0.013, 0.015, 0.017};
    struct screener_options *o = &s->o;
    const int large = is(o->machine, "large");
    int i;
    s->levels = s->classes = large ? 5 : 2;
    s->R = large ? 0.8 : 0.3;
    for (i = 0; i < s->levels && large; i++) {
        s->radius[i] = radius[i];
        s->number[i] = number[i];
        if (i) s->w[i] = s->bar[i] = w[i - 1];
    }
    if (!large) {
        s->radius[0] = 0.0015; s->radius[1] = 0.002;
        s->number[0] = o->balls ? (o->balls + 1)/2 : 389;
        s->number[1] = o->balls ? o->balls/2 : 386;
        s->w[1] = 0.001575; s->bar[1] = 0.0008;
    }
    if (!(o->rpm > 0)) o->rpm = large ? 50 : 180;
    if (o->alpha < 0) o->alpha = large ? 1 : 0.6;
    if (o->beta < 0) o->beta = large ? 0.65 : 0.5;
    if (o->zeta < 0) o->zeta = large ? 0.8 : 0.6;
    if (!(o->rate > 0)) o->rate = large ? 147 : 357;
    if (!(o->seconds > 0)) o->seconds = large ? 25 : 20;
    if (!(o->spacing > 0)) o->spacing = large ? 0.15 : 0.03;
    if (!(o->stiffness > 0)) o->stiffness = large ? 2e4 : 200;
    if (o->wall_friction < 0) o->wall_friction = large ? o->friction : 0.06;
    if (o->rolling < 0) o->rolling = strncmp(o->holes, "model", 5) ? 0 : 1;
    if (o->vane < 0) o->vane = s->R/8;
    if (!large && o->eccentricity >= 40) o->eccentricity *= s->R/0.8;
    for (i = 0; i < s->classes; i++) s->number[i] = ceil(s->number[i]*o->share);
    o->rate *= o->share;
    s->machine.speed = o->rpm*2*PI/60;
    s->machine.alpha = o->alpha*PI/180;
    s->machine.beta = o->beta*PI/180;
    s->machine.u = s->machine.e = 0;
    s->machine.eccentricity = o->eccentricity/1000;
    s->machine.factor = o->factor;
    s->machine.period = o->period;
}
static double level_radius(const screener *s, int level) {   /* 0 is the lowest */
    if (!is(s->o.barrel, "stepped") || s->levels < 2) return s->R;
    return s->R*(1 - 0.15*(s->levels - 1 - level)/(s->levels - 1));
}
static int part_move(screener *s, int part, dem_wall wall, double z) {
    dem_motion motion;
    if (!wall.id) return refused(s->world, DEM_ERROR_ARGUMENT);
    s->part[part].machine = &s->machine;
    s->part[part].place[0] = s->part[part].place[1] = 0;
    s->part[part].place[2] = z;
    motion = tumbler_motion(&s->part[part]);
    return refused(s->world, dem_wall_motion(s->world, wall, &motion));
}

/* The rim: 96 segments, those of the openings left out; a vane at the end of each opening that a
   turning machine comes to first, leading outwards. One profile serves all decks of a uniform barrel;
   a stepped one is a mesh, with a ledge where it narrows. */
static int rim_add(screener *s, dem_material stuff) {
    enum { N = 96 };
    dem_real xy[2*(N + 24)], *xyz;
    int32_t segments[2*(N + 12)], *triangles;
    int i, k, closed[N], count = 0, vanes = 0, points = N, faces = 0;
    const int stepped = is(s->o.barrel, "stepped");
    for (i = 0; i < N; i++) {
        const double turn = (double)i/N*s->o.openings;
        closed[i] = turn - floor(turn) >= s->o.open;
        xy[2*i] = (dem_real)(s->R*cos(2*PI*i/N));
        xy[2*i + 1] = (dem_real)(s->R*sin(2*PI*i/N));
        if (closed[i]) { segments[2*count] = i; segments[2*count++ + 1] = (i + 1)%N; }
    }
    for (i = 0; i < N && s->o.vane > 0 && s->o.open < 1; i++) {
        const double a = 2*PI*i/N, b = a + 0.5, r = s->R - s->o.vane;
        if (!closed[i] || closed[(i + N - 1)%N] || vanes == 12) continue;
        xy[2*points] = (dem_real)(s->R*cos(a) - (s->R - r)*cos(b)); /* inwards, leaning back */
        xy[2*points + 1] = (dem_real)(s->R*sin(a) - (s->R - r)*sin(b));
        segments[2*count] = i;
        segments[2*count++ + 1] = points++;
        vanes++;
    }
    if (!stepped && !count) return 0;           /* all of the rim is open */
    if (!stepped) {
        dem_profile p;
        p.vertex_count = points; p.segment_count = count;
        p.vertices = xy; p.segments = segments;
        s->rim = dem_profile_add(s->world, stuff, &p, DEM_EDGE_RESOLVED);
        return part_move(s, LEVELS, s->rim, 0);
    }
    xyz = (dem_real *)study_alloc((size_t)(6*N*s->levels), sizeof *xyz);
    triangles = (int32_t *)study_alloc((size_t)(12*N*s->levels), sizeof *triangles);
    for (k = 0; k < s->levels; k++)
        for (i = 0; i < N; i++) {
            const int a = 2*N*k + i, b = 2*N*k + (i + 1)%N;
            dem_real *p = xyz + 3*a;
            const double r = level_radius(s, k), top = k + 1 < s->levels ? k + 1 : k + 3;
            p[0] = p[3*N] = (dem_real)(r*cos(2*PI*i/N));
            p[1] = p[3*N + 1] = (dem_real)(r*sin(2*PI*i/N));
            p[2] = (dem_real)(k*s->o.spacing);
            p[3*N + 2] = (dem_real)(top*s->o.spacing);
            if (closed[i]) {
                int32_t *t = triangles + 3*faces;
                t[0] = a; t[1] = b; t[2] = b + N; t[3] = a; t[4] = b + N; t[5] = a + N;
                faces += 2;
            }
            if (k + 1 < s->levels) {            /* ledge from this top to the wider foot above */
                int32_t *t = triangles + 3*faces;
                t[0] = a + N; t[1] = b + N; t[2] = b + 2*N; t[3] = a + N; t[4] = b + 2*N;
                t[5] = a + 2*N;
                faces += 2;
            }
        }
    {
        dem_mesh mesh;
        mesh.vertex_count = 2*N*s->levels; mesh.triangle_count = faces;
        mesh.vertices = xyz; mesh.triangles = triangles;
        s->rim = dem_mesh_add(s->world, stuff, &mesh);
    }
    free(xyz);
    free(triangles);
    return part_move(s, LEVELS, s->rim, 0);
}

static int decks_add(screener *s, dem_material stuff) {
    dem_real edge = (dem_real)(1.02*s->R);
    dem_real corners[12];
    int32_t triangles[6] = {0, 1, 2, 0, 2, 3};
    dem_mesh floor;
    int k;
    for (k = 0; k < 4; k++) {
        corners[3*k] = k == 1 || k == 2 ? edge : -edge;
        corners[3*k + 1] = k > 1 ? edge : -edge;
        corners[3*k + 2] = 0;
    }
    floor.vertex_count = 4; floor.triangle_count = 2;
    floor.vertices = corners; floor.triangles = triangles;
    s->floor = dem_mesh_add(s->world, stuff, &floor);
    if (part_move(s, 0, s->floor, 0)) return 1;
    for (k = 1; k < s->levels; k++) {
        dem_sieve_desc d = DEM_SIEVE_DESC;
        d.kind = is(s->o.holes, "wires") ? DEM_SIEVE_WIRES
            : is(s->o.holes, "plate") ? DEM_SIEVE_SQUARE : DEM_SIEVE_REDUCED;
        d.aperture = (dem_real)(2*s->w[k]);
        d.bar = (dem_real)s->bar[k];
        d.radius = (dem_real)(is(s->o.barrel, "stepped") ? level_radius(s, k - 1) : s->R);
        d.model = is(s->o.holes, "model1") ? 1 : 2;
        d.clearance = d.kind == DEM_SIEVE_REDUCED ? (dem_real)s->o.zeta : 0;
        s->sieve[k] = dem_sieve_add(s->world, stuff, &d);
        if (part_move(s, k, s->sieve[k], k*s->o.spacing)) return 1;
    }
    return 0;
}

static int outlets_add(screener *s) {
    int k, i;
    for (k = 0; k < s->levels; k++) {
        dem_outlet_desc d;
        memset(&d, 0, sizeof d);
        d.frame = s->floor;
        d.beyond = (dem_real)(level_radius(s, k) + 0.05*s->radius[0]);
        d.box = dem_box_make(-10, -10, (dem_real)(k ? k*s->o.spacing : -10), 10, 10,
                             (dem_real)(k + 1 < s->levels ? (k + 1)*s->o.spacing : 10));
        d.wanted_min = (dem_real)(0.99*s->radius[k]);
        d.class_count = s->classes;
        for (i = 0; i < s->classes; i++) d.radius[i] = (dem_real)s->radius[i];
        s->outlet[k] = dem_outlet_add(s->world, &d);
        if (!s->outlet[k].id) return refused(s->world, DEM_ERROR_ARGUMENT);
    }
    return 0;
}

/* A funnel over the machine, standing still: 24 sides, an orifice, a shaft above. */
static int hopper_add(screener *s, dem_material stuff, double z, double wide, double high) {
    enum { N = 24 };
    dem_real xyz[9*N];
    int32_t triangles[12*N];
    const double r[3] = {s->o.orifice, wide, wide}, h[3] = {z, z + 0.8*wide, z + 0.8*wide + high};
    dem_mesh mesh;
    int i, k, n = 0;
    for (k = 0; k < 3; k++)
        for (i = 0; i < N; i++) {
            const int a = N*k + i, b = N*k + (i + 1)%N;
            xyz[3*a] = (dem_real)(r[k]*cos(2*PI*i/N));
            xyz[3*a + 1] = (dem_real)(r[k]*sin(2*PI*i/N));
            xyz[3*a + 2] = (dem_real)h[k];
            if (k == 2) continue;
            triangles[n++] = a; triangles[n++] = b; triangles[n++] = b + N;
            triangles[n++] = a; triangles[n++] = b + N; triangles[n++] = a + N;
        }
    mesh.vertex_count = 3*N; mesh.triangle_count = n/3;
    mesh.vertices = xyz; mesh.triangles = triangles;
    return dem_mesh_add(s->world, stuff, &mesh).id ? 0 : refused(s->world, DEM_ERROR_ARGUMENT);
}
static int feed_add(screener *s, dem_material ball, dem_material wall) {
    dem_feed_desc d;
    double wide = s->R/8, z = s->levels*s->o.spacing, total = 0;
    const double largest = s->radius[s->classes - 1];
    int k;
    memset(&d, 0, sizeof d);
    d.material = ball;
    d.class_count = s->classes;
    for (k = 0; k < s->classes; k++) {
        d.radius[k] = (dem_real)s->radius[k];
        d.amount[k] = s->number[k];
        total += s->number[k]*4*PI/3*pow(s->radius[k], 3);
    }
    d.limited = 1;
    d.round = 1;
    d.seed = 1;
    d.rate = is(s->o.feed, "rate") ? s->o.rate : 0;
    if (is(s->o.feed, "batch")) wide = 0.7*s->R;
    if (is(s->o.feed, "hopper")) {
        const double cross = PI*9*wide*wide/4;
        z += 2*largest;
        if (hopper_add(s, wall, z, 1.5*wide, 3*total/cross)) return 1;
        z += 1.2*wide;
        wide = 1.5*wide - 2*largest;
        d.box.hi.z = (dem_real)(z + 2.5*total/cross);
    } else d.box.hi.z = (dem_real)(z + (is(s->o.feed, "batch") ? s->o.spacing : 2.2*largest));
    d.box.lo = dem_vec3_make((dem_real)-wide, (dem_real)-wide, (dem_real)z);
    d.box.hi.x = d.box.hi.y = (dem_real)wide;
    s->feed = dem_feed_add(s->world, &d);
    return s->feed.id ? 0 : refused(s->world, DEM_ERROR_ARGUMENT);
}

static int screener_create(screener *s, double dt) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = DEM_MATERIAL_DESC;
    dem_material ball, steel;
    dem_pair pair;
    desc.gravity.z = DEM_R(-9.81);
    desc.normal_law = DEM_NORMAL_LINEAR;
    desc.threads = s->o.threads;
    desc.dt = (dem_real)dt;
    s->world = dem_world_create(&desc);
    if (!s->world) { study_fail("%s", dem_create_error(&desc)); return 1; }
    stuff.density = 2500;
    stuff.poisson = DEM_R(0.25);
    stuff.stiffness = (dem_real)s->o.stiffness;
    stuff.restitution = (dem_real)s->o.restitution;
    stuff.friction = (dem_real)s->o.friction;
    ball = dem_material_add(s->world, &stuff);
    steel = dem_material_add(s->world, &stuff);
    if (!ball.id || !steel.id || refused(s->world, dem_pair_get(s->world, ball, steel, &pair)))
        return 1;
    pair.friction = pair.friction_static = (dem_real)s->o.wall_friction;
    pair.rolling_friction = (dem_real)s->o.rolling;
    return refused(s->world, dem_pair_set(s->world, ball, steel, &pair)) || decks_add(s, steel) ||
           rim_add(s, steel) || outlets_add(s) || feed_add(s, ball, steel);
}

static void sample_take(screener *s) {
    dem_sorting sorting;
    dem_feed_state feed;
    const dem_balance balance = dem_balance_get(s->world);
    const int i = s->samples;
    if (i == SAMPLES || dem_sorting_get(s->world, s->outlet, s->levels, &sorting) != DEM_OK) return;
    dem_feed_get(s->world, s->feed, &feed);
    s->time[i] = dem_world_time(s->world);
    s->efficiency[i] = 100*sorting.efficiency_number;
    s->mass_efficiency[i] = 100*sorting.efficiency_mass;
    s->gangue[i] = 100*sorting.gangue_mass;
    s->left[i] = (double)balance.left;
    s->present[i] = (double)balance.present;
    s->fed[i] = (double)feed.total;
    s->samples++;
}
static void frame_write(screener *s, int frame) {
    char name[64];
    snprintf(name, sizeof name, "balls_%05d.vtp", frame);
    refused(s->world, dem_vtp_write(s->world, study_path(name)));
}

/* One machine, run to its end; 0 when it went well. */
static int screener_run(screener *s, const struct screener_options *o, const char *name) {
    dem_advice advice;
    double next = 0, begun, work = 0;
    int i, frame = 0, bad;
    memset(s, 0, sizeof *s);
    s->o = *o;
    screener_settle(s);
    bad = screener_create(s, 0) || refused(s->world, dem_step_advice(s->world, &advice));
    dem_world_destroy(s->world);
    s->world = 0;
    if (bad) return 1;
    s->dt = (double)advice.contact_time/s->o.steps;
    if (screener_create(s, s->dt)) return 1;
    begun = study_clock();
    while (!bad && dem_world_time(s->world) < s->o.seconds - s->dt/2) {
        const double left = (next - dem_world_time(s->world))/s->dt;
        const int steps = left > 1 ? left < 500 ? (int)(left + 0.5) : 500 : 1;
        bad = refused(s->world, dem_world_step(s->world, steps));
        work += (double)steps*(double)dem_balance_get(s->world).present;
        if (dem_world_time(s->world) >= next - s->dt/2) {
            sample_take(s);
            next += s->o.seconds/(SAMPLES - 1);
        }
        if (frame < s->o.frames && dem_world_time(s->world) >= frame*s->o.seconds/s->o.frames)
            frame_write(s, frame++);
        study_progress(name, fmin(1, dem_world_time(s->world)/s->o.seconds), work);
    }
    s->compute = study_clock() - begun;
    if (!bad) {
        dem_sorting sorting;
        dem_feed_state feed;
        const dem_balance balance = dem_balance_get(s->world);
        int blinded = 0, late = 2*s->samples/3, last = s->samples - 1;
        char text[64];
        dem_sorting_get(s->world, s->outlet, s->levels, &sorting);
        dem_feed_get(s->world, s->feed, &feed);
        study_result("efficiency_number", 100*sorting.efficiency_number, "%");
        study_result("efficiency_mass", 100*sorting.efficiency_mass, "%");
        for (i = 0; i < s->levels; i++) {
            dem_outlet_state state;
            dem_outlet_get(s->world, s->outlet[i], &state);
            snprintf(text, sizeof text, "deck%d.sorted", i + 1);
            study_result(text, (double)state.sorted, "");
            snprintf(text, sizeof text, "deck%d.gangue", i + 1);
            study_result(text, (double)state.gangue, "");
            if (i) blinded += dem_sieve_blinded(s->world, s->sieve[i], DEM_R(0.1));
        }
        study_result("gangue_number", 100*sorting.gangue_number, "%");
        study_result("gangue_mass", 100*sorting.gangue_mass, "%");
        study_result("fed", (double)feed.total, "");
        study_result("present", (double)balance.present, "");
        study_result("left", (double)balance.left, "");
        study_result("missing", (double)feed.total - (double)(balance.present + balance.left), "");
        study_result("rate", last > late ? (s->left[last] - s->left[late])/
                     (s->time[last] - s->time[late]) : 0, "1/s");
        study_result("blinded", blinded, "");
        study_result("overlap", (double)dem_counters_get(s->world).overlap_max, "");
        study_result("compute", s->compute, "s");
        if (feed.total != balance.present + balance.left) study_fail("balls are missing");
    }
    return bad;
}
static void screener_end(screener *s) {
    dem_world_destroy(s->world);
    s->world = 0;
}

/* ---- sweeps ---- */

typedef struct sweep {
    const char *name, *label;          /* of the part; of the axis */
    int count;
    double value[12];
    double seed[12];                   /* what the thesis found, < 0: not printed */
    void (*set)(struct screener_options *o, double value);
} sweep;
static void set_rpm(struct screener_options *o, double v) { o->rpm = v; }
static void set_rate(struct screener_options *o, double v) {
    if (v > 0) o->rate = v; else o->feed = "batch";
}
static void set_alpha(struct screener_options *o, double v) { o->alpha = v; }
static void set_beta(struct screener_options *o, double v) { o->beta = v; }
static void set_eccentricity(struct screener_options *o, double v) { o->eccentricity = v; }
static void set_factor(struct screener_options *o, double v) {
    o->factor = v < 0 ? 1 : v;         /* < 0: turns freely */
    o->period = v > 0 ? 0.02 : 0;
}
static void set_friction(struct screener_options *o, double v) { o->wall_friction = v; }

static const sweep sweeps[] = {
    {"rpm", "machine [1/min]", 5, {10, 25, 50, 150, 250}, {40, -1, 78, 72, 58}, set_rpm},
    {"rate", "feed [1/s], 0: batch", 5, {0, 37, 74, 147, 294}, {-1, -1, -1, 78, -1}, set_rate},
    {"alpha", "alpha [deg]", 5, {0, 0.5, 1, 2, 4}, {76, -1, 78.2, -1, -1}, set_alpha},
    {"beta", "beta [deg]", 5, {0, 0.3, 0.65, 1.3, 2.6}, {-1, -1, 78.2, -1, -1}, set_beta},
    {"ecc", "eccentricity [mm]", 5, {0, 20, 40, 100, 300}, {-1, -1, 80, -1, -1}, set_eccentricity},
    {"K", "K of the swing; -1: free", 5, {-1, 0, 0.3, 0.7, 1}, {58, 69, -1, 75, -1}, set_factor},
    {"mu", "friction of the machine", 6, {0, 0.04, 0.06, 0.1, 0.2, 0.3}, {-1, -1, -1, -1, -1, -1},
     set_friction},
};

/* Runs one sweep; a picture of efficiency against its value and one of efficiency over time. */
static void sweep_run(const sweep *w, const struct screener_options *base, const char *tag) {
    static double time[12][SAMPLES], over[12][SAMPLES], gangue[12][SAMPLES];
    static char names[12][32];
    double x[12], number[12], mass[12], rate[12], bad_share[12], sx[12], sy[12];
    const double *columns[5];
    study_figure f, t, g;
    char file[96];
    int i, k, n = 0, m = 0;
    memset(&f, 0, sizeof f);
    memset(&t, 0, sizeof t);
    memset(&g, 0, sizeof g);
    for (i = 0; i < w->count; i++) {
        static screener s;
        struct screener_options o = *base;
        w->set(&o, w->value[i]);
        snprintf(names[n], sizeof names[n], "%s%g", w->name, w->value[i]);
        if (is(w->name, "rate") && !(w->value[i] > 0)) snprintf(names[n], sizeof names[n], "batch");
        snprintf(study.prefix, sizeof study.prefix, "%s%s%s.", tag, *tag ? "." : "", names[n]);
        if (!screener_run(&s, &o, names[n])) {
            x[n] = w->value[i];
            number[n] = s.efficiency[s.samples - 1];
            mass[n] = s.mass_efficiency[s.samples - 1];
            bad_share[n] = s.gangue[s.samples - 1];
            k = 2*s.samples/3;
            rate[n] = (s.left[s.samples - 1] - s.left[k])/(s.time[s.samples - 1] - s.time[k]);
            for (k = 0; k < SAMPLES; k++) {
                const int at = k < s.samples ? k : s.samples - 1;
                time[n][k] = s.time[at];
                over[n][k] = s.efficiency[at];
                gangue[n][k] = s.gangue[at];
            }
            study_curve(&t, names[n], STUDY_LINE, SAMPLES, time[n], over[n]);
            study_curve(&g, names[n], STUDY_LINE, SAMPLES, time[n], gangue[n]);
            n++;
        }
        screener_end(&s);
        if (w->seed[i] >= 0) { sx[m] = w->value[i]; sy[m++] = w->seed[i]; }
    }
    study.prefix[0] = 0;
    f.title = "Sorting efficiency";
    t.title = "Sorting efficiency over time";
    g.title = "Gangue over time";
    f.x_label = w->label;
    f.y_label = "efficiency [%]";
    f.y1 = 100;
    study_curve(&f, "by number", STUDY_LINE, n, x, number);
    study_curve(&f, "by mass", STUDY_DASHED, n, x, mass);
    study_curve(&f, "gangue share, mass", STUDY_FAINT, n, x, bad_share);
    if (m) study_curve(&f, "[FEN]", STUDY_DOTS, m, sx, sy);
    if (n) {
        for (k = 0; k < n; k++) {
            f.x0 = k ? fmin(f.x0, x[k]) : x[k];
            f.x1 = k ? fmax(f.x1, x[k]) : x[k];
        }
        snprintf(file, sizeof file, "%s%s%s.svg", tag, *tag ? "_" : "", w->name);
        study_figure_write(&f, file);
        t.x_label = g.x_label = "time [s]";
        t.y_label = "efficiency by number [%]";
        g.y_label = "gangue, share of mass [%]";
        snprintf(file, sizeof file, "%s%s%s_time.svg", tag, *tag ? "_" : "", w->name);
        study_figure_write(&t, file);
        snprintf(file, sizeof file, "%s%s%s_gangue.svg", tag, *tag ? "_" : "", w->name);
        study_figure_write(&g, file);
        columns[0] = x; columns[1] = number; columns[2] = mass; columns[3] = bad_share;
        columns[4] = rate;
        snprintf(file, sizeof file, "%s%s%s.csv", tag, *tag ? "_" : "", w->name);
        study_csv(file, "value,efficiency_number,efficiency_mass,gangue_mass,rate", n, 5, columns);
    }
}
static const sweep *sweep_of(const char *name) {
    size_t i;
    for (i = 0; i < sizeof sweeps/sizeof *sweeps; i++) if (is(sweeps[i].name, name)) return &sweeps[i];
    return 0;
}
/* One run more, under a name of its own. */
static void also(const struct screener_options *o, const char *name) {
    static screener s;
    snprintf(study.prefix, sizeof study.prefix, "%s.", name);
    screener_run(&s, o, name);
    screener_end(&s);
    study.prefix[0] = 0;
}

int main(int argc, char **argv) {
    struct screener_options o;
    int i;
    study_options(argc, argv, "A tumbling screening machine after [FEN] section 4.4.", table,
                  (int)(sizeof table/sizeof *table));
    study_begin(options.out);
    o = options;
    if (is(o.study, "run")) {
        static screener s;
        FILE *report;
        const double *columns[6];
        if (!screener_run(&s, &o, "screener")) {
            columns[0] = s.time; columns[1] = s.efficiency; columns[2] = s.gangue;
            columns[3] = s.left; columns[4] = s.present; columns[5] = s.fed;
            study_csv("time.csv", "time,efficiency_number,gangue_mass,left,present,fed", s.samples,
                      6, columns);
            report = study_open("report.txt");
            if (report) { dem_world_report(s.world, report); study_close(report, "report.txt"); }
        }
        screener_end(&s);
    } else if (is(o.study, "speed")) {
        sweep_run(sweep_of("rpm"), &o, is(o.holes, "model2") ? "" : o.holes);
    } else if (is(o.study, "feed")) sweep_run(sweep_of("rate"), &o, "");
    else if (is(o.study, "inclination")) {
        sweep_run(sweep_of("alpha"), &o, "");
        sweep_run(sweep_of("beta"), &o, "");
    } else if (is(o.study, "eccentricity")) {
        if (o.beta < 0) o.beta = 1;            /* as its Fig 4.20 */
        sweep_run(sweep_of("ecc"), &o, "");
    } else if (is(o.study, "oscillation")) {
        if (!(o.rpm > 0)) o.rpm = 150;         /* as its Fig 4.21 */
        if (o.zeta < 0) o.zeta = 0.6;
        sweep_run(sweep_of("K"), &o, "");
    } else if (is(o.study, "friction")) {
        o.machine = "glass";
        o.factor = 0;
        if (o.zeta < 0) o.zeta = 0;            /* as its Fig 4.22 */
        sweep_run(sweep_of("mu"), &o, "");
    } else if (is(o.study, "size")) {
        static const int balls[3] = {775, 4950, 9900};
        static const double seconds[3] = {20, 25, 45}, hours[3] = {2.5, 36, 153};
        char name[32];
        o.machine = "glass";
        o.factor = 0;
        for (i = 0; i < 3; i++) {
            o.balls = i ? balls[i] : 0;
            if (!(options.seconds > 0)) o.seconds = seconds[i];
            snprintf(name, sizeof name, "N%d", balls[i]);
            also(&o, name);
            snprintf(name, sizeof name, "N%d.seed_compute", balls[i]);
            study_result(name, 3600*hours[i], "s");
        }
    } else if (is(o.study, "holes")) {
        static const char *const holes[4] = {"model1", "model2", "wires", "plate"};
        for (i = 0; i < 4; i++) { o.holes = holes[i]; also(&o, holes[i]); }
    } else if (is(o.study, "choices")) {
        also(&o, "chosen");
        o.restitution = 0.8;        also(&o, "restitution0.8"); o = options;
        o.stiffness = 8e4;          also(&o, "stiffness8e4");   o = options;
        o.friction = 0.4;           also(&o, "friction0.4");    o = options;
        o.spacing = 0.25;           also(&o, "spacing0.25");    o = options;
        o.open = 0.25;              also(&o, "open0.25");       o = options;
        o.vane = 0;                 also(&o, "no_vane");        o = options;
        o.eccentricity = 20;        also(&o, "eccentricity20"); o = options;
        o.barrel = "stepped";       also(&o, "stepped");
    } else {                                    /* check: a small part of it all, for trying */
        o.share = 0.05;
        o.seconds = 3;
        also(&o, "model2");
        o.holes = "wires";
        also(&o, "wires");
    }
    return study_end();
}
