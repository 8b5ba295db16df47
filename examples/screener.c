/* screener.c - a tumbling screening machine: five decks, four sieves, balls of five sizes.

   The machine is that of [ALK07] (section 4.4), a thesis on contacts in a tumbling screening machine.
   A barrel of radius 80 cm tumbles at 50 revolutions per minute on a plate inclined by 1 and 0.65
   degrees. Its sieves have square holes of half width w = 17, 15, 13, 11 mm with bars of width g = w
   between them. 3483 balls of radius 10 to 18 mm are fed at 147 a second. Every deck releases its own
   size at the rim; smaller balls that leave with it are gangue. --machine glass is the other example
   of the thesis: R = 30 cm, one sieve (w = 1.575 mm, g = 0.8 mm), glass balls of 3 and 4 mm.

   The thesis does not print these quantities. We chose them; each is an option and part of --study
   choices:
     density 2500 kg/m3, stiffness and restitution of a linear spring and dashpot, softened: contacts
     last about 1.6 ms (large machine)
     friction 0.2 between balls, and 0.06 with the machine, the optimum of its friction study. Friction
     on a sieve uses the velocity of a ball without its spin there (eq 4.27 to 4.30), so balls slide.
     On reduced holes, which are a plane, a rolling friction of 1 has this effect here. Free balls
     would roll, and a ball that rolls on a rotating plate is not flung out but runs in circles. Wires
     and plates brake rolling without rolling friction
     decks 0.15 m apart (other machines: 0.03 m); all of the rim is open (--open, --openings and --vane
     give a rim with openings and deflectors that lead to them)
     eccentricity 40 mm where a figure does not give it (all but 4.20), u = e = 0
     a feed from a disc of 0.1 m in the middle, above the uppermost sieve

   build:  cc -O2 -std=c99 examples/screener.c dem.c -o build/screener -lm
   run:    build/screener, build/screener --study speed, build/screener --help

   --machine small is not in the thesis: R = 15 cm, three decks, and a feed without end. --study hour
   runs it for an hour of machine time and counts the balls of each size at every step.

   Results of one run. A sweep prints one such block per value, with a prefix: rpm50.efficiency_number.
   With --repeats it also prints blocks rpm50.seed2 and so on, and the mean and spread over all of them.
     efficiency_number, efficiency_mass   %, eq 4.33 and 4.35: mean over decks of sorted/all that left
     deckN.sorted, deckN.gangue           balls that left deck N, 1 the lowest
     deckN.rate                           kg/s that left it, eq 4.40
     gangue_number, gangue_mass           %, of all that left, eq 4.41
     fed, present, left, missing          balls; missing = fed - present - left is 0
     rate                                 balls/s that left, over the last third
    steady                               s after which the efficiency stays within 2 points of its end (the mean over the
                                         last tenth of the time)
     blinded                              balls stuck in holes at the end (none with reduced holes)
     overlap                              largest overlap over radius
     dt                                   s, at the end: that of --steps, or smaller (screener_step)
     compute                              s of wall time
     steps, unbalanced_steps              --study hour: all steps; steps at which the balance of a size
                                          was wrong */
#include "../dem.h"
#include "sorting.h"
#include "study.h"
#include "study_replay.h"
#include "sifting.h"
#include "tumbler.h"

#define PI 3.14159265358979323846
enum { LEVELS = SIFTING_DECKS };

static struct screener_options {
    double rpm, alpha, beta, eccentricity, factor, period, friction, wall_friction, zeta, rate;
    double seconds, stiffness, restitution, spacing, open, vane, steps, orifice, rolling, share;
    double radius, narrowing, phase, plate_u, plate_e, aperture, bars, thickness, lift, slot, density, size, size_spread;
    double aspect, feed_radius, feed_height;
    const char *machine, *holes, *feed, *barrel, *grains, *study, *values, *out;
    int decks, openings, threads, frames, balls, seed, repeats, replay, quick, brief;
} options = {0, -1, -1, -1, 1, 0, 0.2, 0.06, -1, 0, 0, 0, 0.5, 0, 1, -1, 22, 0.08, -1, 1,
             0, 0.15, 0, 0, 0, 1, 0, 0, 0, 0, 2500, 1, 0, 1.3, 0, 0,
             "large", "model2", "rate", "uniform", "sphere", "run", "", "build/out/screener", 0, 6, 1, 0, 0, 1, 1, 0, 0, 0};

static const study_option table[] = {
    {"machine", STUDY_CHOICE, &options.machine, 0, 0, "large|glass|small", "which example"},
    {"decks", STUDY_INT, &options.decks, 0, LEVELS, "", "the lowest of the machine's are left out; 0: all"},
    {"radius", STUDY_REAL, &options.radius, 0, 10, "m", "of the barrel; 0: .8 (large), .3 (glass), .15 (small)"},
    {"holes", STUDY_CHOICE, &options.holes, 0, 0, "model1|model2|wires|bars|plate|round|slots", "of the sieves"},
    {"aperture", STUDY_REAL, &options.aperture, 0.1, 10, "", "holes, times those of the machine"},
    {"bars", STUDY_REAL, &options.bars, 0, 10, "", "g/w: wire or bar over half a hole; 0: 1 (large, small), .51 (glass)"},
    {"thickness", STUDY_REAL, &options.thickness, 0, 1, "", "of plates, over the bar"},
    {"lift", STUDY_REAL, &options.lift, 0, 1, "", "between the layers of wires, over the wire"},
    {"slot", STUDY_REAL, &options.slot, 0, 100, "", "length of slots over their width, 1 and more; 0: infinite"},
    {"zeta", STUDY_REAL, &options.zeta, -1, 1, "",
        "clearance of reduced holes; -1: .8 (large), .6 (others)"},
    {"rpm", STUDY_REAL, &options.rpm, 0, 1000, "1/min", "machine; 0: 50 (large), 180 (others)"},
    {"alpha", STUDY_REAL, &options.alpha, -1, 20, "deg", "inclination; -1: 1 (large), .6 (others)"},
    {"beta", STUDY_REAL, &options.beta, -1, 20, "deg", "inclination; -1: .65 (large), .5 (others)"},
    {"eccentricity", STUDY_REAL, &options.eccentricity, -1, 1000, "mm",
        "of the shafts; -1: 40, 8 (small)"},
    {"phase", STUDY_REAL, &options.phase, -360, 360, "deg", "of the main shaft at the start"},
    {"plate-u", STUDY_REAL, &options.plate_u, -1, 1, "m", "dimension u of the inclined plate"},
    {"plate-e", STUDY_REAL, &options.plate_e, -1, 1, "m", "dimension e of the inclined plate"},
    {"factor", STUDY_REAL, &options.factor, 0, 5, "", "K: barrel over machine; 1 free, 0 held"},
    {"period", STUDY_REAL, &options.period, 0, 10, "s", "of the barrel's swing; 0: it goes on"},
    {"friction", STUDY_REAL, &options.friction, 0, 5, "", "between balls"},
    {"wall-friction", STUDY_REAL, &options.wall_friction, 0, 5, "", "with the machine"},
    {"rolling", STUDY_REAL, &options.rolling, -1, 5, "",
        "rolling friction with the machine; -1: 1 on reduced holes (balls slide), else 0"},
    {"feed", STUDY_CHOICE, &options.feed, 0, 0, "rate|batch|hopper", "how balls come"},
    {"rate", STUDY_REAL, &options.rate, 0, 1e5, "1/s", "feed; 0: 147 (large), 357 (glass), 60 (small)"},
    {"feed-radius", STUDY_REAL, &options.feed_radius, 0, 10, "m", "of the disc fed; 0: R/8, batch .7 R"},
    {"feed-height", STUDY_REAL, &options.feed_height, 0, 10, "m", "above the highest deck; 0: one spacing"},
    {"orifice", STUDY_REAL, &options.orifice, 0.01, 1, "m", "radius of the hopper's"},
    {"balls", STUDY_INT, &options.balls, 0, 1000000, "",
        "glass: how many; 0: 775, of which 389 are small"},
    {"grains", STUDY_CHOICE, &options.grains, 0, 0, "sphere|pair|rod|tetra",
        "shape: 1, 2, 3 or 4 spheres, of the volume of the ball; not with reduced holes"},
    {"aspect", STUDY_REAL, &options.aspect, 1, 3, "", "length over width of a pair (at most 1.9) or rod"},
    {"size", STUDY_REAL, &options.size, 0.1, 10, "", "radii, times those of the machine"},
    {"size-spread", STUDY_REAL, &options.size_spread, 0, 0.5, "", "largest relative deviation from the radius of a class"},
    {"density", STUDY_REAL, &options.density, 1, 3e4, "kg/m3", "of the grains"},
    {"seconds", STUDY_REAL, &options.seconds, 0, 1e5, "s", "of machine time; 0: 25 (large), 20 (others)"},
    {"share", STUDY_REAL, &options.share, 0.001, 1, "", "of the balls and of their rate: for trying"},
    {"barrel", STUDY_CHOICE, &options.barrel, 0, 0, "uniform|stepped",
        "stepped: narrower below, by --narrowing"},
    {"narrowing", STUDY_REAL, &options.narrowing, 0, 0.9, "", "of the lowest deck of a stepped barrel"},
    {"spacing", STUDY_REAL, &options.spacing, 0, 1, "m", "of decks; 0: .15 (large), .03 (others)"},
    {"openings", STUDY_INT, &options.openings, 1, 12, "", "in the rim of each deck"},
    {"open", STUDY_REAL, &options.open, 0.01, 1, "", "share of the rim that is open"},
    {"vane", STUDY_REAL, &options.vane, -1, 0.5, "m",
        "deflector at each opening of a uniform barrel; -1: R/8"},
    {"stiffness", STUDY_REAL, &options.stiffness, 0, 1e9, "N/m", "0: 2e4 (large), 200 (glass), 2000 (small)"},
    {"restitution", STUDY_REAL, &options.restitution, 0.01, 1, "", "of balls and machine"},
    {"steps", STUDY_REAL, &options.steps, 20, 1000, "", "time steps in the shortest contact"},
    {"threads", STUDY_INT, &options.threads, 0, 64, "", "0: as many as there are"},
    {"seed", STUDY_INT, &options.seed, 1, 1000000, "", "of the feed"},
    {"repeats", STUDY_INT, &options.repeats, 1, 20, "", "of each run of a sweep, with seeds on from that"},
    {"quick", STUDY_FLAG, &options.quick, 0, 0, "", "fewer balls and less time, under 20 s"},
    {"short", STUDY_FLAG, &options.brief, 0, 0, "", STUDY_SHORT " and balls five times as dense"},
    {"replay", STUDY_FLAG, &options.replay, 0, 0, "", "write replay.html, which a browser plays"},
    {"frames", STUDY_INT, &options.frames, 0, 100000, "", "VTP files of the balls over the run"},
    {"out", STUDY_TEXT, &options.out, 0, 0, "", "folder for results"},
    {"study", STUDY_CHOICE, &options.study, 0, 0,
        "run|speed|feed|nozzle|inclination|eccentricity|oscillation|friction|size|holes|grains|rim|parameters|choices|hour|check",
        "what to run"},
    {"values", STUDY_TEXT, &options.values, 0, 0, "", STUDY_VALUES},
};
enum { OPTIONS = sizeof table/sizeof *table };

typedef struct screener {
    struct screener_options o;
    dem_world *world;
    tumbler machine;
    tumbler_part part[LEVELS + 1];     /* floor, sieves from below, rim */
    dem_wall floor, sieve[LEVELS], rim;
    dem_feed feed;
    dem_outlet outlet[LEVELS];
    int levels, classes;
    double R, w[LEVELS], bar[LEVELS], radius[LEVELS], number[LEVELS], dt, dt_first;
    double bound;                      /* radius of the bounding sphere of a grain over that of the ball of its volume */
    dem_shape shape;                   /* null: spheres */
    sifting curves;
    double compute;
} screener;

static const double STEADY = 2;        /* %, by which a steady curve may differ from its end */

static int is(const char *a, const char *b) { return !strcmp(a, b); }
static int refused(dem_world *world, dem_result result) {
    if (result != DEM_OK) study_fail("%s", dem_world_error_get(world));
    return result != DEM_OK;
}

static int reduced(const struct screener_options *o) { return !strncmp(o->holes, "model", 5); }

/* Fills in the values that the thesis gives for the chosen machine, and our choices for the rest. */
static void screener_settle(screener *s) {
    static const double radius[5] = {0.010, 0.012, 0.014, 0.016, 0.018};
    static const double number[5] = {1210, 832, 611, 467, 363}, w[4] = {0.011, 0.013, 0.015, 0.017};
    struct screener_options *o = &s->o;
    const int large = is(o->machine, "large"), glass = is(o->machine, "glass");
    int i;
    s->levels = s->classes = large ? 5 : glass ? 2 : 3;
    s->R = o->radius > 0 ? o->radius : large ? 0.8 : glass ? 0.3 : 0.15;
    for (i = 0; i < s->levels && !glass; i++) {  /* small: the lower part, at 3/10 */
        s->radius[i] = radius[i]*(large ? 1 : 0.3);
        s->number[i] = number[i];
        if (i) s->w[i] = s->bar[i] = w[i - 1]*(large ? 1 : 0.3);
    }
    if (glass) {
        s->radius[0] = 0.0015; s->radius[1] = 0.002;
        s->number[0] = o->balls ? (o->balls + 1)/2 : 389;
        s->number[1] = o->balls ? o->balls/2 : 386;
        s->w[1] = 0.001575; s->bar[1] = 0.0008;
    }
    for (i = 0; o->decks && o->decks < s->levels && i < o->decks; i++) {   /* the highest */
        s->w[i] = i ? s->w[s->levels - o->decks + i] : 0;
        s->bar[i] = i ? s->bar[s->levels - o->decks + i] : 0;
    }
    if (o->decks && o->decks < s->levels) s->levels = o->decks;
    for (i = 0; i < s->levels; i++) {
        s->w[i] *= o->aperture;
        s->bar[i] = o->bars > 0 ? o->bars*s->w[i] : s->bar[i]*o->aperture;
    }
    for (i = 0; i < s->classes; i++) s->radius[i] *= o->size;
    if (!(o->rpm > 0)) o->rpm = large ? 50 : 180;
    if (o->alpha < 0) o->alpha = large ? 1 : 0.6;
    if (o->beta < 0) o->beta = large ? 0.65 : 0.5;
    if (o->zeta < 0) o->zeta = large ? 0.8 : 0.6;
    if (!(o->rate > 0)) o->rate = large ? 147 : glass ? 357 : 60;
    if (o->brief) o->rate *= 5;                 /* in a short time as many balls lie on each other as later in a long run */
    if (!(o->seconds > 0)) o->seconds = large ? 25 : 20;
    if (!(o->spacing > 0)) o->spacing = large ? 0.15 : 0.03;
    if (!(o->stiffness > 0)) o->stiffness = large ? 2e4 : glass ? 200 : 2000;
    if (o->rolling < 0) o->rolling = reduced(o) ? 1 : 0;
    if (!(o->feed_radius > 0)) o->feed_radius = is(o->feed, "batch") ? 0.7*s->R : s->R/8;
    if (!(o->feed_height > 0)) o->feed_height = o->spacing;
    if (o->vane < 0) o->vane = s->R/8;
    if (o->eccentricity < 0) o->eccentricity = is(o->machine, "small") ? 8 : 40;
    if (o->brief && !is(o->feed, "rate")) o->share *= is(o->feed, "hopper") ? 0.03 : 0.3;   /* all at once */
    for (i = 0; i < s->classes; i++) s->number[i] = ceil(s->number[i]*o->share);
    o->rate *= o->share;
    s->machine.speed = o->rpm*2*PI/60;
    s->machine.alpha = o->alpha*PI/180;
    s->machine.beta = o->beta*PI/180;
    s->machine.phase = o->phase*PI/180;
    s->machine.u = o->plate_u;
    s->machine.e = o->plate_e;
    s->machine.eccentricity = o->eccentricity/1000;
    s->machine.factor = o->factor;
    s->machine.period = o->period;
}
static double level_radius(const screener *s, int level) {   /* 0 is the lowest */
    if (!is(s->o.barrel, "stepped") || s->levels < 2) return s->R;
    return s->R*(1 - s->o.narrowing*(s->levels - 1 - level)/(s->levels - 1));
}
static int part_move(screener *s, int part, dem_wall wall, double z) {
    dem_motion motion;
    if (!wall.id) return refused(s->world, DEM_ERROR_ARGUMENT);
    s->part[part].machine = &s->machine;
    s->part[part].place[0] = s->part[part].place[1] = 0;
    s->part[part].place[2] = z;
    motion = tumbler_motion(&s->part[part]);
    return refused(s->world, dem_wall_motion_set(s->world, wall, &motion));
}

/* Adds the rim: 96 segments without those of the openings. Each opening has a vane at the end that
   leads in the direction of rotation; it reaches inwards and leads balls out. One profile serves all
   decks of a uniform barrel. A stepped barrel is a mesh, with a ledge where it narrows and no vanes. */
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
        s->rim = dem_wall_profile_add(s->world, stuff, &p, DEM_EDGE_RESOLVED);
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
        s->rim = dem_wall_mesh_add(s->world, stuff, &mesh);
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
    s->floor = dem_wall_mesh_add(s->world, stuff, &floor);
    if (part_move(s, 0, s->floor, 0)) return 1;
    for (k = 1; k < s->levels; k++) {
        dem_sieve_desc d = DEM_SIEVE_DESC;
        static const struct { const char *word; dem_sieve_kind kind; } kinds[5] = {{"wires", DEM_SIEVE_WIRES},
            {"bars", DEM_SIEVE_BARS}, {"plate", DEM_SIEVE_SQUARE}, {"round", DEM_SIEVE_ROUND}, {"slots", DEM_SIEVE_SLOTS}};
        int i;
        d.kind = DEM_SIEVE_REDUCED;
        for (i = 0; i < 5; i++) if (is(s->o.holes, kinds[i].word)) d.kind = kinds[i].kind;
        d.aperture = (dem_real)(2*s->w[k]);
        d.bar = (dem_real)s->bar[k];
        if (d.kind == DEM_SIEVE_SLOTS) d.length = (dem_real)(fmax(1, s->o.slot)*2*s->w[k]*(s->o.slot > 0));
        if (d.kind == DEM_SIEVE_WIRES) d.lift = (dem_real)(s->o.lift*s->bar[k]);
        if (d.kind >= DEM_SIEVE_SQUARE && d.kind <= DEM_SIEVE_SLOTS) d.thickness = (dem_real)(s->o.thickness*s->bar[k]);
        d.radius = (dem_real)(is(s->o.barrel, "stepped") ? level_radius(s, k - 1) : s->R);
        d.model = d.kind != DEM_SIEVE_REDUCED ? 0 : is(s->o.holes, "model1") ? 1 : 2;
        d.clearance = d.kind == DEM_SIEVE_REDUCED ? (dem_real)s->o.zeta : 0;
        s->sieve[k] = dem_wall_sieve_add(s->world, stuff, &d);
        if (part_move(s, k, s->sieve[k], k*s->o.spacing)) return 1;
    }
    return 0;
}

/* Returns the radius of the smallest ball that the sieve below a deck holds back. */
static double wanted(const screener *s, int level) {
    int i;
    for (i = 0; i + 1 < s->classes && !(s->radius[i] > s->w[level]);) i++;
    return level ? s->radius[i] : s->radius[0];
}
static int outlets_add(screener *s) {
    int k, i;
    for (k = 0; k < s->levels; k++) {
        dem_outlet_desc d;
        memset(&d, 0, sizeof d);
        d.frame = s->floor;
        d.beyond = (dem_real)(level_radius(s, k) + 0.05*s->radius[0]);
        /* below all classes of a deck: bounding spheres, with the deviations within a class */
        d.box = dem_box_make(-10, -10, (dem_real)(k ? k*s->o.spacing : -10), 10, 10,
                             (dem_real)(k + 1 < s->levels ? (k + 1)*s->o.spacing : 10));
        d.wanted_min = (dem_real)(0.99*(1 - s->o.size_spread)*s->bound*wanted(s, k));
        d.class_count = s->classes;
        for (i = 0; i < s->classes; i++) d.radius[i] = (dem_real)(s->bound*s->radius[i]);
        s->outlet[k] = dem_outlet_add(s->world, &d);
        if (!s->outlet[k].id) return refused(s->world, DEM_ERROR_ARGUMENT);
    }
    return 0;
}

/* Adds a funnel at rest above the machine: 24 sides, an orifice, and a shaft above. */
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
    return dem_wall_mesh_add(s->world, stuff, &mesh).id ? 0 : refused(s->world, DEM_ERROR_ARGUMENT);
}
static int feed_add(screener *s, dem_material ball, dem_material wall) {
    dem_feed_desc d;
    dem_sizes sizes[LEVELS];
    double wide = s->o.feed_radius, z = (s->levels - 1)*s->o.spacing + s->o.feed_height, total = 0;
    const double largest = s->bound*(1 + s->o.size_spread)*s->radius[s->classes - 1];
    int k;
    memset(&d, 0, sizeof d);
    memset(sizes, 0, sizeof sizes);
    d.material = ball;
    d.class_count = s->classes;
    for (k = 0; k < s->classes; k++) {
        d.radius[k] = (dem_real)s->radius[k];
        d.shapes[k] = s->shape;
        if (s->o.size_spread > 0) {
            sizes[k].kind = DEM_SIZES_UNIFORM;
            sizes[k].by_count = 1;
            sizes[k].min = (dem_real)((1 - s->o.size_spread)*s->radius[k]);
            sizes[k].max = (dem_real)((1 + s->o.size_spread)*s->radius[k]);
            d.sizes[k] = &sizes[k];
        }
        d.amount[k] = s->number[k];
        total += s->number[k]*4*PI/3*pow(s->radius[k], 3);
    }
    d.limited = !is(s->o.machine, "small");
    d.round = 1;
    d.seed = (uint64_t)s->o.seed;
    d.rate = is(s->o.feed, "rate") ? s->o.rate : 0;
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

/* Adds the shape of the grains, a cluster. `bound` becomes its bounding radius over that of the ball of the same volume. */
static int shape_add(screener *s) {
    const dem_real a = (dem_real)(s->o.aspect - 1), t = DEM_R(0.5);
    const dem_real row[9] = {a, 0, 0, -a, 0, 0, 0, 0, 0}, tetra[12] = {t, t, t, t, -t, -t, -t, t, -t, -t, -t, t};
    dem_cluster_desc d = DEM_CLUSTER_DESC;
    dem_shape_info info;
    s->bound = 1;
    s->shape.id = 0;
    if (is(s->o.grains, "sphere")) return 0;
    d.count = is(s->o.grains, "pair") ? 2 : is(s->o.grains, "rod") ? 3 : 4;
    d.positions = d.count == 4 ? tetra : row;
    d.radius = 1;
    s->shape = dem_shape_cluster_add(s->world, &d);
    if (!s->shape.id || dem_shape_get(s->world, s->shape, &info) != DEM_OK) return refused(s->world, DEM_ERROR_ARGUMENT);
    s->bound = (double)info.radius/cbrt(3*(double)info.volume/(4*PI));
    return 0;
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
    if (!s->world) { study_fail("%s", dem_world_create_error_get(&desc)); return 1; }
    stuff.density = (dem_real)s->o.density;
    stuff.poisson = DEM_R(0.25);
    stuff.stiffness = (dem_real)s->o.stiffness;
    stuff.restitution = (dem_real)s->o.restitution;
    stuff.friction = (dem_real)s->o.friction;
    ball = dem_material_add(s->world, &stuff);
    steel = dem_material_add(s->world, &stuff);
    if (!ball.id || !steel.id || shape_add(s) || refused(s->world, dem_pair_get(s->world, ball, steel, &pair)))
        return 1;
    pair.friction = pair.friction_static = (dem_real)s->o.wall_friction;
    pair.rolling_friction = (dem_real)s->o.rolling;
    return refused(s->world, dem_pair_set(s->world, ball, steel, &pair)) || decks_add(s, steel) ||
           rim_add(s, steel) || outlets_add(s) || feed_add(s, ball, steel);
}

static dem_feed_state fed(const screener *s) {
    dem_feed_state state;
    memset(&state, 0, sizeof state);
    dem_feed_get(s->world, s->feed, &state);
    return state;
}
static dem_outlet_state let_out(const screener *s, int deck) {
    dem_outlet_state state;
    memset(&state, 0, sizeof state);
    dem_outlet_get(s->world, s->outlet[deck], &state);
    return state;
}
/* rate_late returns the balls/s that left over the last third of the samples; deck_rate the kg/s that
   left one deck (from 0) over the whole time, eq 4.40. */
static double rate_late(const screener *s) {
    const sifting *c = &s->curves;
    const int last = c->samples - 1, late = 2*c->samples/3;
    return last > late ? (c->left[last] - c->left[late])/(c->time[last] - c->time[late]) : 0;
}
static double deck_rate(const screener *s, int deck) {
    return let_out(s, deck).total_mass/dem_world_time_get(s->world);
}
/* Returns 1 if for each size the balls fed are those present and those that left, and if the sum over
   the sizes agrees with the world's counts. */
static int screener_balanced(const screener *s) {
    const dem_bodies b = dem_bodies_get(s->world);
    const dem_body_counts balance = dem_body_counts_get(s->world);
    const dem_feed_state feed = fed(s);
    uint64_t found[LEVELS] = {0}, left = 0;
    int i, k, ok;
    for (i = 0; i < b.count; i++)
        for (k = 0; k < s->classes; k++)
            found[k] += fabs((double)b.positions[4*i + 3]/s->radius[k] - 1) < 1e-3;
    for (i = 0; i < s->levels; i++) {
        const dem_outlet_state out = let_out(s, i);
        for (k = 0; k < s->classes; k++) found[k] += out.count[k];
        left += out.total;
    }
    ok = balance.left == left && feed.total == balance.inserted &&
         balance.inserted == balance.present + balance.left;
    for (k = 0; k < s->classes; k++) ok = ok && feed.fed[k] == found[k];
    return ok;
}
static void frame_write(screener *s, int frame) {
    char name[64];
    snprintf(name, sizeof name, "balls_%05d.vtp", frame);
    refused(s->world, dem_vtp_write(s->world, study_path(name)));
}

/* Draws the present balls, coloured by radius: from the side with the decks, or from above those that
   are above the highest sieve. */
static void picture_draw(screener *s, int above, const char *title, const char *file) {
    enum { RIM = 97 };
    const dem_bodies b = dem_bodies_get(s->world);
    const double high = s->levels*s->o.spacing;
    double *v[4], x[LEVELS][RIM], y[LEVELS][RIM];
    dem_pose pose;
    study_figure f;
    int i, k, n = 0;
    memset(&f, 0, sizeof f);
    memset(&pose, 0, sizeof pose);
    for (k = 0; k < 4; k++) v[k] = (double *)study_alloc((size_t)b.count + 1, sizeof(double));
    dem_wall_pose_get(s->world, s->sieve[s->levels - 1], &pose);
    for (i = 0; i < b.count; i++) {
        const dem_real *p = b.positions + 4*i;
        const double up = (double)(p[2] - pose.position.z);
        if (above && up < -0.05*s->R) continue;
        v[0][n] = (double)p[0];
        v[1][n] = (double)p[above ? 1 : 2];
        v[2][n] = (double)p[3];
        v[3][n++] = 1000*(double)p[3];
    }
    for (k = above ? s->levels - 1 : 0; k < s->levels; k++) {
        dem_wall_pose_get(s->world, k ? s->sieve[k] : s->floor, &pose);
        for (i = 0; i < RIM; i++) {              /* its rim, as a tilted circle */
            const double a = level_radius(s, k)*cos(2*PI*i/(RIM - 1));
            const double c = level_radius(s, k)*sin(2*PI*i/(RIM - 1));
            x[k][i] = (double)pose.position.x + a*(double)pose.rotation[0] +
                c*(double)pose.rotation[1];
            y[k][i] = above ? (double)pose.position.y + a*(double)pose.rotation[3] +
                c*(double)pose.rotation[4]
                : (double)pose.position.z + a*(double)pose.rotation[6] +
                c*(double)pose.rotation[7];
        }
        study_curve(&f, 0, STUDY_OUTLINE, RIM, x[k], y[k]);
    }
    f.title = title;
    f.x_label = "x [m]";
    f.y_label = above ? "y [m]" : "z [m]";
    f.bar_label = "radius [mm]";
    f.equal = 1;
    f.size = 760;
    f.x0 = -1.1*s->R; f.x1 = 1.1*s->R;
    f.y0 = above ? -1.1*s->R : -0.1*high; f.y1 = above ? 1.1*s->R : 1.15*high;
    f.lo = 1000*s->radius[0]; f.hi = 1000*s->radius[s->classes - 1];
    f.disc_count = n;
    f.disc_x = v[0]; f.disc_y = v[1]; f.disc_r = v[2]; f.disc_value = v[3];
    study_figure_write(&f, file);
    for (k = 0; k < 4; k++) free(v[k]);
}

/* Takes this number of steps. --steps is the number of steps in a single contact. A ball pressed by many contacts may need
   more. Then the step becomes smaller by a tenth, in the way in which dem.h reduces a step that it chose itself. */
static int screener_step(screener *s, int steps) {
    const double least = 0.3*s->dt_first;
    dem_result result = dem_world_step(s->world, steps);
    while (result == DEM_ERROR_TIME_STEP && s->dt > least) {
        s->dt *= 0.9;
        if (refused(s->world, dem_world_dt_set(s->world, (dem_real)s->dt))) return 1;
        result = dem_world_step(s->world, 1);
    }
    return refused(s->world, result);
}

/* Runs one machine to its end; returns 0 if it succeeds. */
static int screener_run(screener *s, const struct screener_options *o, const char *name) {
    dem_advice advice;
    const int counting = is(o->study, "hour");      /* balls, at every step */
    study_replay f;
    double begun, work = 0, unbalanced = 0, finest[LEVELS];
    int i, frame = 0, drawn = 0, bad;
    memset(s, 0, sizeof *s);
    s->o = *o;
    screener_settle(s);
    bad = screener_create(s, 0) || refused(s->world, dem_step_advice_get(s->world, &advice));
    dem_world_destroy(s->world);
    s->world = 0;
    if (bad) return 1;
    s->dt = s->dt_first = (double)advice.contact_time/s->o.steps;
    if (screener_create(s, s->dt)) return 1;
    for (i = 0; i < s->levels; i++) finest[i] = 0.99*(1 - s->o.size_spread)*s->bound*wanted(s, i);
    sifting_begin(&s->curves, s->world, s->floor, s->o.spacing, s->outlet, finest, s->levels, s->feed, s->o.seconds);
    dem_world_check_print(s->world, stderr);
    f = study_replay_open(s->world, o->replay ? 250 : 0, s->o.seconds, "A tumbling screening machine");
    begun = study_clock();
    while (!bad && dem_world_time_get(s->world) < s->o.seconds - s->dt/2) {
        const double next = sifting_next(&s->curves), left = (next - dem_world_time_get(s->world))/s->dt;
        const int steps = left > 1 && !counting ? left < 500 ? (int)(left + 0.5) : 500 : 1;
        bad = screener_step(s, steps);
        if (counting) unbalanced += !screener_balanced(s);
        work += (double)steps*(double)dem_body_counts_get(s->world).present;
        if (dem_world_time_get(s->world) >= next - s->dt/2) sifting_take(&s->curves);
        if (study_replay_due(&f)) {
            const sifting *c = &s->curves;
            const int last = c->samples - 1;
            study_replay_value(&f, "balls in the machine", (double)dem_body_counts_get(s->world).present);
            if (last >= 0) study_replay_value(&f, "efficiency by number (%)", c->value[SIFTING_EFFICIENCY][c->decks][last]);
            if (last >= 0) study_replay_value(&f, "gangue, share of mass (%)", c->value[SIFTING_GANGUE_MASS][c->decks][last]);
            study_replay_frame(&f);
        }
        if (!drawn && is(o->study, "run") && 2*dem_world_time_get(s->world) >= s->o.seconds) {
            picture_draw(s, 0, "Half way through, from the side", "side.svg");
            picture_draw(s, 1, "The highest deck, half way through", "top.svg");
            drawn = 1;
        }
        if (frame < s->o.frames && dem_world_time_get(s->world) >= frame*s->o.seconds/s->o.frames)
            frame_write(s, frame++);
        study_progress(name, fmin(1, dem_world_time_get(s->world)/s->o.seconds), work);
    }
    s->compute = study_clock() - begun;
    study_replay_close(&f);
    sifting_end(&s->curves);
    if (!bad) {
        sorting sorted;
        const dem_feed_state feed = fed(s);
        const dem_body_counts balance = dem_body_counts_get(s->world);
        int blinded = 0;
        char text[64];
        sorting_get(s->world, s->outlet, s->levels, &sorted);
        study_result("efficiency_number", 100*sorted.efficiency_number, "%");
        study_result("efficiency_mass", 100*sorted.efficiency_mass, "%");
        for (i = 0; i < s->levels; i++) {
            const dem_outlet_state out = let_out(s, i);
            snprintf(text, sizeof text, "deck%d.sorted", i + 1);
            study_result(text, (double)out.sorted, "");
            snprintf(text, sizeof text, "deck%d.gangue", i + 1);
            study_result(text, (double)out.gangue, "");
            snprintf(text, sizeof text, "deck%d.rate", i + 1);
            study_result(text, deck_rate(s, i), "kg/s");
            if (i) blinded += dem_sieve_blinded_get(s->world, s->sieve[i], DEM_R(0.1));
        }
        study_result("gangue_number", 100*sorted.gangue_number, "%");
        study_result("gangue_mass", 100*sorted.gangue_mass, "%");
        study_result("fed", (double)feed.total, "");
        study_result("present", (double)balance.present, "");
        study_result("left", (double)balance.left, "");
        study_result("missing", (double)feed.total - (double)(balance.present + balance.left), "");
        study_result("rate", rate_late(s), "1/s");
        study_result("steady", sifting_steady(&s->curves, SIFTING_EFFICIENCY, s->levels, STEADY), "s");
        study_result("blinded", blinded, "");
        study_result("overlap", (double)dem_counters_get(s->world).overlap_max, "");
        study_result("dt", s->dt, "s");
        study_result("compute", s->compute, "s");
        if (counting) {
            study_result("steps", (double)dem_counters_get(s->world).steps, "");
            study_result("unbalanced_steps", unbalanced, "");
        }
        if (feed.total != balance.present + balance.left || unbalanced > 0)
            study_fail("balls are missing");
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
    double thesis[12];                 /* efficiency in the thesis; < 0: not printed there */
    void (*set)(struct screener_options *o, double value);
    const char *words[12];             /* names instead of numbers */
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
static void set_nozzle(struct screener_options *o, double v) { o->feed = "hopper"; o->orifice = v/1000; }
static void set_size(struct screener_options *o, double v) {
    static const double rest[3] = {20, 25, 45};
    o->balls = v > 775 ? (int)v : 0;   /* the smallest is not of equal parts */
    if (!(options.seconds > 0)) o->seconds = rest[v < 1000 ? 0 : v < 9000 ? 1 : 2];
}
static void set_holes(struct screener_options *o, double v) {
    static const char *const holes[7] = {"model1", "model2", "wires", "plate", "round", "bars", "slots"};
    o->holes = holes[(int)v];
}
static void set_grains(struct screener_options *o, double v) {
    static const char *const grains[4] = {"sphere", "pair", "rod", "tetra"};
    o->grains = grains[(int)v];
}
static void set_rim(struct screener_options *o, double v) {
    static const double open[5] = {1, 0.5, 0.25, 0.25, 0.25}, vane[5] = {0, -1, -1, 0, 0.2};
    o->open = open[(int)v];
    o->vane = vane[(int)v];
}
/* One parameter of the machine or of the feed that no other sweep varies. */
static void set_parameter(struct screener_options *o, double v) {
    switch ((int)v) {
    case 1: o->phase = 90; break;
    case 2: o->plate_u = o->plate_e = 0.05; break;
    case 3: o->decks = 3; break;
    case 4: o->radius = 0.6; break;
    case 5: o->aperture = 1.05; break;
    case 6: o->bars = 0.5; break;
    case 7: o->size_spread = 0.04; break;
    case 8: o->density = 5000; break;
    case 9: o->feed_radius = 0.3; break;
    case 10: o->feed_height = 0.3; break;
    default: break;
    }
}

#define NONE {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1}
static const sweep sweeps[] = {
    {"rpm", "machine [1/min]", 7, {10, 25, 50, 75, 100, 150, 250}, {40, -1, 78, -1, -1, 72, 58},
     set_rpm, {0}},
    {"rate", "feed [1/s], 0: batch", 5, {0, 37, 74, 147, 294}, {-1, -1, -1, 78, -1}, set_rate, {0}},
    {"nozzle", "radius of the nozzle [mm]", 5, {30, 40, 50, 60, 80}, NONE, set_nozzle, {0}},
    {"alpha", "alpha [deg]", 5, {0, 0.5, 1, 2, 4}, {76, -1, 78.2, -1, -1}, set_alpha, {0}},
    {"beta", "beta [deg]", 5, {0, 0.3, 0.65, 1.3, 2.6}, {-1, -1, 78.2, -1, -1}, set_beta, {0}},
    {"level_beta", "beta [deg] at alpha = 0", 5, {0, 0.3, 0.65, 1.3, 2.6}, {-1, -1, 76, -1, -1}, set_beta, {0}},
    {"ecc", "eccentricity [mm]", 5, {0, 20, 40, 100, 300}, {-1, -1, 80, -1, -1}, set_eccentricity, {0}},
    {"K", "K of the swing; -1: free", 5, {-1, 0, 0.3, 0.7, 1}, {58, 69, -1, 75, -1}, set_factor, {0}},
    {"mu", "friction of the machine", 6, {0, 0.04, 0.06, 0.1, 0.2, 0.3}, NONE, set_friction, {0}},
    {"N", "balls", 3, {775, 4950, 9900}, NONE, set_size, {0}},
    {"holes", "holes, as in the table", 7, {0, 1, 2, 3, 4, 5, 6}, NONE, set_holes,
     {"model1", "model2", "wires", "plate", "round", "bars", "slots"}},
    {"grains", "grains, as in the table", 4, {0, 1, 2, 3}, NONE, set_grains, {"sphere", "pair", "rod", "tetra"}},
    {"rim", "rim, as in the table", 5, {0, 1, 2, 3, 4}, NONE, set_rim,
     {"open", "half_vanes", "quarter_vanes", "quarter", "quarter_long"}},
    {"parameter", "parameter, as in the table", 11, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, NONE, set_parameter,
     {"chosen", "phase90", "plate50mm", "decks3", "radius0.6", "aperture1.05", "bars0.5", "spread0.04", "density5000",
      "feed_radius0.3", "feed_height0.3"}},
};

/* The results of a sweep: for each value means over the seeds, and the spread (standard deviation) of one seed. */
enum { NUMBER, MASS, GANGUE, RATE, STEADY_AT, LEFT, LOWEST, DECK_RATE, MEASURES = DECK_RATE + LEVELS };
static const struct { const char *name, *unit; } measures[MEASURES] = {
    {"efficiency_number", "%"}, {"efficiency_mass", "%"}, {"gangue_mass", "%"}, {"rate", "1/s"}, {"steady", "s"},
    {"left", ""}, {"lowest", ""},
    {"deck1.rate", "kg/s"}, {"deck2.rate", "kg/s"}, {"deck3.rate", "kg/s"}, {"deck4.rate", "kg/s"}, {"deck5.rate", "kg/s"}};

typedef struct sweep_result {
    int count, decks;
    double value[12], mean[MEASURES][12], spread[MEASURES][12];
    sifting curves[12];
    char name[12][32];
} sweep_result;

/* Runs all seeds of one value. */
static int value_run(const struct screener_options *base, const char *tag, sweep_result *r) {
    static screener s;
    const int n = r->count;
    int i, k;
    memset(&r->curves[n], 0, sizeof r->curves[n]);
    for (i = 0; i < base->repeats; i++) {
        struct screener_options o = *base;
        double found[MEASURES];
        char more[24] = "";
        o.seed += i;
        if (i) snprintf(more, sizeof more, ".seed%d", o.seed);
        snprintf(study.prefix, sizeof study.prefix, "%s%s%s%s.", tag, *tag ? "." : "", r->name[n],
                 more);
        if (screener_run(&s, &o, r->name[n])) { screener_end(&s); return 1; }
        r->decks = s.levels;
        k = s.curves.samples - 1;
        found[NUMBER] = s.curves.value[SIFTING_EFFICIENCY][s.levels][k];
        found[MASS] = s.curves.value[SIFTING_EFFICIENCY_MASS][s.levels][k];
        found[GANGUE] = s.curves.value[SIFTING_GANGUE_MASS][s.levels][k];
        found[RATE] = rate_late(&s);
        found[STEADY_AT] = sifting_steady(&s.curves, SIFTING_EFFICIENCY, s.levels, STEADY);
        found[LEFT] = s.curves.left[k];
        found[LOWEST] = (double)let_out(&s, 0).total;
        for (k = 0; k < LEVELS; k++) found[DECK_RATE + k] = k < s.levels ? deck_rate(&s, k) : 0;
        for (k = 0; k < MEASURES; k++) {                     /* spread: the sum of squares so far */
            const double before = r->mean[k][n];
            r->mean[k][n] += (found[k] - before)/(i + 1);
            r->spread[k][n] += (found[k] - before)*(found[k] - r->mean[k][n]);
        }
        sifting_add(&r->curves[n], &s.curves);
        screener_end(&s);
    }
    snprintf(study.prefix, sizeof study.prefix, "%s%s%s.", tag, *tag ? "." : "", r->name[n]);
    for (k = 0; k < MEASURES && base->repeats > 1; k++) {
        char text[48];
        r->spread[k][n] = sqrt(r->spread[k][n]/(base->repeats - 1));
        if (k >= DECK_RATE + r->decks) continue;
        snprintf(text, sizeof text, "mean.%s", measures[k].name);
        study_result(text, r->mean[k][n], measures[k].unit);
        snprintf(text, sizeof text, "spread.%s", measures[k].name);
        study_result(text, r->spread[k][n], measures[k].unit);
    }
    study.prefix[0] = 0;
    r->count++;
    return 0;
}

/* Draws one quantity of one deck (or of the machine) over time, with a curve for each value. */
static void values_draw(const sweep_result *r, int quantity, int deck, const char *title, const char *file) {
    study_figure f;
    int i;
    memset(&f, 0, sizeof f);
    f.title = title;
    f.x_label = "time [s]";
    f.y_label = sifting_names[quantity].label;
    for (i = 0; i < r->count; i++)
        study_curve(&f, r->name[i], STUDY_LINE, r->curves[i].samples, r->curves[i].time, r->curves[i].value[quantity][deck]);
    study_figure_write(&f, file);
}
/* Draws what left each deck over time at one value: sorted balls, and gangue dashed. */
static void outputs_draw(const sifting *c, const char *value, const char *file) {
    char names[2][LEVELS][32], title[64];
    study_figure f;
    int k, which;
    memset(&f, 0, sizeof f);
    snprintf(title, sizeof title, "Balls that left each deck, %s", value);
    f.title = title;
    f.x_label = "time [s]";
    f.y_label = "balls";
    for (which = 0; which < 2; which++)
        for (k = 0; k < c->decks; k++) {
            snprintf(names[which][k], sizeof names[0][0], "deck %d, %s", k + 1, which ? "gangue" : "sorted");
            if (which && !k) continue;                       /* the lowest deck has none */
            study_curve(&f, names[which][k], which ? STUDY_DASHED : STUDY_LINE, c->samples, c->time,
                        c->value[which ? SIFTING_GANGUE : SIFTING_SORTED][k]);
        }
    study_figure_write(&f, file);
}

/* Runs one sweep. Its pictures: efficiency and gangue against the value, beside the thesis; the rate of
   each deck against the value; over time, of each value, efficiency, gangue, flows, balls in the machine and on the
   lowest deck; for each value, what left each deck. NAME_curves.csv has all curves of all values and decks. */
static void sweep_run(const sweep *w, const struct screener_options *base, const char *tag) {
    static sweep_result r;
    static const struct { int quantity, lowest; const char *title, *name; } over_time[6] = {
        {SIFTING_EFFICIENCY, 0, "Sorting efficiency over time", "time"},
        {SIFTING_GANGUE_MASS, 0, "Gangue over time", "gangue"},
        {SIFTING_THROUGH, 0, "Feed over time", "feed"},
        {SIFTING_OUT, 0, "Outflow over time", "outflow"},
        {SIFTING_ON, 0, "Mass in the machine over time", "mass"},
        {SIFTING_SORTED, 1, "Balls that left the lowest deck", "lowest"}};
    double thesis_x[12], thesis_y[12], asked[12];
    study_figure figure[2];
    char file[128], decks[LEVELS][16], start[64];
    FILE *csv;
    int i, k, cases, known = 0;
    memset(&r, 0, sizeof r);
    memset(figure, 0, sizeof figure);
    snprintf(start, sizeof start, "%s%s%s", tag, *tag ? "_" : "", w->name);
    memcpy(asked, w->value, sizeof asked);
    cases = study_values_take(base->values, w->words[0] != 0, asked, w->count, 12);
    for (i = 0; i < cases; i++) {
        struct screener_options o = *base;
        w->set(&o, asked[i]);
        if (!study_within(table, OPTIONS, &options, &o)) return;
    }
    for (i = 0; i < cases; i++) {
        struct screener_options o = *base;
        w->set(&o, asked[i]);
        r.value[r.count] = asked[i];
        if (w->words[0]) snprintf(r.name[r.count], sizeof r.name[0], "%s", w->words[(int)asked[i]]);
        else snprintf(r.name[r.count], sizeof r.name[0], "%s%g", w->name, asked[i]);
        if (is(w->name, "rate") && !(asked[i] > 0))
            snprintf(r.name[r.count], sizeof r.name[0], "batch");
        if (value_run(&o, tag, &r)) continue;
        for (k = 0; k < w->count && known < 12; k++)
            if (w->thesis[k] >= 0 && fabs(w->value[k] - asked[i]) <= 1e-9*fabs(asked[i])) {
                thesis_x[known] = asked[i];
                thesis_y[known++] = w->thesis[k];
            }
    }
    if (!r.count) return;
    figure[0].title = "Sorting efficiency";
    figure[0].y_label = "efficiency [%]";
    figure[0].y1 = 100;
    figure[1].title = "Output rates";
    figure[1].y_label = "rate of a deck [kg/s]";
    study_curve(&figure[0], "by number", STUDY_LINE, r.count, r.value, r.mean[NUMBER]);
    study_curve(&figure[0], "by mass", STUDY_DASHED, r.count, r.value, r.mean[MASS]);
    study_curve(&figure[0], "gangue, share of mass", STUDY_FAINT, r.count, r.value, r.mean[GANGUE]);
    if (known) study_curve(&figure[0], "[ALK07]", STUDY_DOTS, known, thesis_x, thesis_y);
    for (k = 0; k < r.decks; k++) {
        snprintf(decks[k], sizeof decks[k], "deck %d", k + 1);
        study_curve(&figure[1], decks[k], STUDY_LINE, r.count, r.value, r.mean[DECK_RATE + k]);
    }
    for (k = 0; k < 2; k++) {
        figure[k].x_label = w->label;
        figure[k].x0 = r.value[0];
        figure[k].x1 = r.value[r.count - 1];
        snprintf(file, sizeof file, "%s%s.svg", start, k ? "_rates" : "");
        study_figure_write(&figure[k], file);
    }
    for (k = 0; k < 6; k++) {
        snprintf(file, sizeof file, "%s_%s.svg", start, over_time[k].name);
        values_draw(&r, over_time[k].quantity, over_time[k].lowest ? 0 : r.curves[0].decks, over_time[k].title, file);
    }
    for (i = 0; i < r.count; i++) {
        snprintf(file, sizeof file, "%s_outputs_%s.svg", start, r.name[i]);
        outputs_draw(&r.curves[i], r.name[i], file);
    }
    snprintf(file, sizeof file, "%s.csv", start);
    csv = study_open(file);
    if (csv) {
        fputs("value", csv);
        for (k = 0; k < MEASURES; k++) fprintf(csv, ",%s,spread", measures[k].name);
        for (i = 0; i < r.count; i++)
            for (k = -1; k < MEASURES; k++)
                if (k < 0) fprintf(csv, "\n%.9g", r.value[i]);
                else fprintf(csv, ",%.9g,%.3g", r.mean[k][i], r.spread[k][i]);
        fputc('\n', csv);
        study_close(csv, file);
    }
    snprintf(file, sizeof file, "%s_curves.csv", start);
    csv = study_open(file);
    if (csv) {
        sifting_heading(csv);
        for (i = 0; i < r.count; i++) sifting_rows(&r.curves[i], csv, r.name[i]);
        study_close(csv, file);
    }
}
static const sweep *sweep_of(const char *name) {
    size_t i;
    for (i = 0; i < sizeof sweeps/sizeof *sweeps; i++) if (is(sweeps[i].name, name)) return &sweeps[i];
    return 0;
}
/* Makes another run, with its name as the prefix of its results. */
static void also(const struct screener_options *o, const char *name) {
    static screener s;
    snprintf(study.prefix, sizeof study.prefix, "%s.", name);
    screener_run(&s, o, name);
    screener_end(&s);
    study.prefix[0] = 0;
}

int main(int argc, char **argv) {
    struct screener_options o;
    study_options(argc, argv, "A tumbling screening machine after [ALK07] section 4.4.", table,
                  OPTIONS);
    if (options.quick) { /* options given by name keep their values */
        options.share = 0.6;
        options.seconds = 15;
        study_options(argc, argv, "", table, OPTIONS);
    }
    if (options.brief) {
        options.repeats = 1;
        options.seconds = 1.2;
    }
    study_begin(options.out);
    if (is(options.study, "run") || is(options.study, "choices") || is(options.study, "hour") || is(options.study, "check"))
        study_values_unused(options.values, "this study");
    o = options;
    if (is(o.study, "run")) {
        static screener s;
        FILE *report;
        if (!screener_run(&s, &o, "screener")) {
            sifting_write(&s.curves, "curves");
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
        o.alpha = 0;
        sweep_run(sweep_of("level_beta"), &o, "");
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
    } else if (is(o.study, "size")) {          /* as its Fig 4.23 */
        o.machine = "glass";
        o.factor = 0;
        sweep_run(sweep_of("N"), &o, "");
    } else if (is(o.study, "parameters")) {
        if (o.brief) o.share *= 0.3;
        sweep_run(sweep_of("parameter"), &o, "");
    } else if (is(o.study, "grains")) {
        if (reduced(&o)) o.holes = "wires";
        sweep_run(sweep_of("grains"), &o, "");
    } else if (is(o.study, "holes") || is(o.study, "nozzle") || is(o.study, "rim")) sweep_run(sweep_of(o.study), &o, "");
    else if (is(o.study, "choices")) {
        also(&o, "chosen");
        o.restitution = 0.8;        also(&o, "restitution0.8"); o = options;
        o.stiffness = 8e4;          also(&o, "stiffness8e4");   o = options;
        o.friction = 0.4;           also(&o, "friction0.4");    o = options;
        o.spacing = 0.25;           also(&o, "spacing0.25");    o = options;
        o.open = 0.25;              also(&o, "open0.25");       o = options;
        o.wall_friction = 0.2;
        if (!(o.seconds > 0)) o.seconds = 15;
        also(&o, "wall_friction0.2"); o = options;
        o.eccentricity = 20;        also(&o, "eccentricity20"); o = options;
        o.barrel = "stepped";       also(&o, "stepped");
    } else if (is(o.study, "hour")) {
        o.machine = "small";
        if (!(o.seconds > 0)) o.seconds = 3600;
        also(&o, "hour");
    } else {                                    /* check: a small part of each study */
        o.share = 0.05;
        o.seconds = 3;
        also(&o, "model2");
        o.holes = "wires";
        also(&o, "wires");
    }
    return study_end();
}
