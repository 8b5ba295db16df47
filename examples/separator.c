/* separator.c - a corona electrostatic separator: metal and plastic fall into different bins.

   After [CRI14] and a second paper, on GPUs (Critelli, Tasora, Colledani, Mazhar 2014). Grains of a few millimetres,
   shredded from circuit boards, slide down a plate onto a rotor at 0 V that rotates under an electrode at 30 kV. Ions
   from a corona charge the grains that do not conduct: they stick to the rotor and leave it late or at a brush. Grains
   that conduct take charge from the rotor by touching it and are thrown off early. The results are the mass that lands
   in each bin, and purity and recovery of metal against the position of a splitter. examples/corona.h has the physics,
   examples/separator.h the machine; both use public functions of dem.h only.

   --setting ours     impulses: Coulomb's cones, warm starts, a tolerance, steps of 0.25 ms, of fragments 0.05 ms (default)
             seeds    impulses as in the papers: convex cones, steps of 1 ms, 100 sweeps with cold starts
             springs  softened Hertz contacts, steps chosen from the contact time
   Quantities that the papers do not print are our choice and have options; docs/separator.md compares some of them.

   build:  cc -O2 -std=c99 examples/separator.c dem.c -o build/separator -lm
   run:    build/separator, build/separator --study feed --repeats 4, build/separator --help

   Results of one run. A sweep prints one such block per value and seed, with a prefix, and means with standard errors.
     metal.x_mean, metal.x_sd         m from the rotor's axis in the plane of the bins, by mass; also for plastic and
                                      middling. If a stuff is fed in two forms, also for each: metal.sphere.x_mean
     metal.landed, metal.brushed      grains; fraction of the mass that the brush took (x < -R/2)
     splitterNN.purity, .recovery     %: metal in the mass beyond splitter NN; mass of metal beyond it in all metal that
                                      landed; NN = 00 to 59, from --splitter-from over 200 mm
     products.*                       with middlings: purity and recovery (%) of plastic, middlings and metal at the two
                                      splitters for which the mean of purity + recovery - 100 over the three is largest
     best_splitter, best_quality      m; %: the splitter at which purity + recovery - 100 is largest, and this value
     fed, binned, present, missing    grains; missing = fed - binned - present is 0
     unbalanced_steps                 steps at which the balance of a class or material was wrong: 0
     sweeps_mean, residual_max        sweeps per step; m/s (impulses)
     unsolved_steps, overlap_max      steps that did not reach their tolerance; largest overlap over the radius
     steps, compute, grain_steps      steps; s of wall time; grains times steps per second of wall time */
#include "../dem.h"
#include "corona.h"
#include "separator.h"
#include "study.h"
#include "study_replay.h"

enum { BINS = 200, SPLITTERS = 60, GROUPS = 3 + SEPARATOR_PARTS, VALUES = 12, REPEATS = 32 };
static const double bin_first = -0.4, bin_wide = 0.005;      /* m */

static struct separator_options {
    double voltage, rpm, rotor, electrode, distance, angle, width, feed_width, rate, seconds, drain;
    double feeder_speed, feeder_angle, size_min, size_mean, size_max, size_modulus, metal, middling, middling_metal;
    double density_metal, density_plastic, permittivity, friction, drum_friction, plate_friction, rolling, restitution;
    double strength, current, wire, wire_distance, ions_begin, ions_end, layer, contact_time, leak_time, brush_time;
    double brush_middle, brush_half, scatter, coulomb, wind_x, wind_y, swirl, bins, splitter_from;
    double dt, tolerance, range, young, mixed, air_density, air_viscosity, feeder_length, feeder_edge, near_interval,
        touch;
    double roughness, at_contact, in_flight, field_share, image_permittivity;
    const char *sizes, *metal_form, *plastic_form, *drag, *setting, *cone, *solver, *law, *study, *values, *resume, *out;
    int sweeps, cold, threads, seed, repeats, image, pull, in_front, quick, brief, replay, check;
} options = {
    30, 44.8, 0.160, 0.019, 0.267, 30, 0.03, 0.182, 5000, 6, 2,
    0.72, 20, 1, 2, 4, 1.5, 0.5, 0, 0.5,
    8400, 946, 2.5, 0.2, 0.5, 0.3, 0, 0.1,
    -1, 1e-4, 0.1, 0.21, -10, 50, 10, 1e-4, 10, 5e-3,
    270, 19.3, 0.3, 10, 0, 0, 0, -0.5, 0.2,
    0, 0, 0, 5e6, 0, 1.204, 1.81e-5, 0.07, -0.015, 1, 2,
    0.8, 0.832, 1, 1, 1,
    "zhang", "sphere", "sphere", "schiller", "ours", "", "seidel", "hertz", "run", "", "", "build/out/separator",
    0, -1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0};

static const study_option table[] = {
    {"voltage", STUDY_REAL, &options.voltage, -100, 100, "kV", "of the electrode; its sign is that of the ions"},
    {"rpm", STUDY_REAL, &options.rpm, 0.1, 1000, "1/min", "rotor"},
    {"rotor", STUDY_REAL, &options.rotor, 0.02, 1, "m", "radius"},
    {"electrode", STUDY_REAL, &options.electrode, 1e-3, 0.5, "m", "radius"},
    {"distance", STUDY_REAL, &options.distance, 0.03, 2, "m", "between their axes"},
    {"angle", STUDY_REAL, &options.angle, -90, 90, "deg", "of the electrode above the horizontal"},
    {"width", STUDY_REAL, &options.width, 0.008, 0.3, "m", "slice of the machine, periodic along its axis"},
    {"feed-width", STUDY_REAL, &options.feed_width, 0.008, 3, "m", "of the whole machine, for the rate"},
    {"rate", STUDY_REAL, &options.rate, 1, 1e6, "1/s", "grains fed to the whole machine"},
    {"seconds", STUDY_REAL, &options.seconds, 0.05, 1e5, "s", "of feeding"},
    {"drain", STUDY_REAL, &options.drain, 0, 100, "s", "longest time after feeding until all have landed"},
    {"feeder-speed", STUDY_REAL, &options.feeder_speed, 0, 3, "m/s", "of grains that come onto the plate"},
    {"feeder-angle", STUDY_REAL, &options.feeder_angle, 0, 60, "deg", "of the plate below the horizontal"},
    {"feeder-length", STUDY_REAL, &options.feeder_length, 0.045, 1, "m", "of the plate"},
    {"feeder-edge", STUDY_REAL, &options.feeder_edge, -0.1, 0.05, "m",
        "x where the plate ends, 4 mm above the rotor's top"},
    {"sizes", STUDY_CHOICE, &options.sizes, 0, 0, "zhang|weibull|uniform", "distribution of diameters, by number"},
    {"size-min", STUDY_REAL, &options.size_min, 0.05, 20, "mm", "smallest diameter (of equal volume)"},
    {"size-mean", STUDY_REAL, &options.size_mean, 0.05, 20, "mm", "Zhang: mean; Weibull: scale"},
    {"size-max", STUDY_REAL, &options.size_max, 0.05, 20, "mm", "largest"},
    {"size-modulus", STUDY_REAL, &options.size_modulus, 0.1, 20, "", "Weibull"},
    {"metal", STUDY_REAL, &options.metal, 0, 1, "", "share of the grains that are metal"},
    {"middlings", STUDY_REAL, &options.middling, 0, 1, "", "share that are both; the rest is plastic"},
    {"middling-metal", STUDY_REAL, &options.middling_metal, 0, 1, "", "share of metal in them, by volume"},
    {"metal-form", STUDY_CHOICE, &options.metal_form, 0, 0, "sphere|flake|shaving|fragment", "shape"},
    {"plastic-form", STUDY_CHOICE, &options.plastic_form, 0, 0, "sphere|flake|shaving|fragment",
        "shape, of middlings too"},
    {"mixed", STUDY_REAL, &options.mixed, 0, 1, "", "share of metal and plastic that stay spheres"},
    {"density-metal", STUDY_REAL, &options.density_metal, 1, 3e4, "kg/m3", ""},
    {"density-plastic", STUDY_REAL, &options.density_plastic, 1, 3e4, "kg/m3", ""},
    {"permittivity", STUDY_REAL, &options.permittivity, 1, 1000, "", "of plastic, relative"},
    {"friction", STUDY_REAL, &options.friction, 0, 5, "", "between grains"},
    {"drum-friction", STUDY_REAL, &options.drum_friction, 0, 5, "", "with the rotor"},
    {"plate-friction", STUDY_REAL, &options.plate_friction, 0, 5, "", "with the feeder's plate and the electrode"},
    {"rolling", STUDY_REAL, &options.rolling, 0, 5, "", "rolling friction with the rotor"},
    {"restitution", STUDY_REAL, &options.restitution, 0.01, 1, "", "of all"},
    {"strength", STUDY_REAL, &options.strength, -1, 1e7, "V/m",
        "field that ions charge in; 0: that of the electrode; -1: 11.818 U + 514.9"},
    {"current", STUDY_REAL, &options.current, 0, 1, "A/m2", "of ions; 0: they charge at once"},
    {"wire", STUDY_REAL, &options.wire, 1e-3, 10, "mm", "radius of the corona's wire, for its onset"},
    {"wire-distance", STUDY_REAL, &options.wire_distance, 0.03, 2, "m", "of the wire from the rotor's axis"},
    {"roughness", STUDY_REAL, &options.roughness, 0.1, 1, "", "of the wire, Peek's m"},
    {"ions-begin", STUDY_REAL, &options.ions_begin, -170, 180, "deg",
        "where the corona's window begins, clockwise from the top"},
    {"ions-end", STUDY_REAL, &options.ions_end, -170, 180, "deg", "where it ends"},
    {"layer", STUDY_REAL, &options.layer, 0, 1000, "mm", "depth above the rotor of corona and brush"},
    {"contact-time", STUDY_REAL, &options.contact_time, 0, 10, "s",
        "in which metal on the rotor takes its charge; 0: at once"},
    {"leak-time", STUDY_REAL, &options.leak_time, 0, 1e6, "s",
        "in which plastic on the rotor loses its charge; 0: never"},
    {"brush-time", STUDY_REAL, &options.brush_time, 0, 1, "s", "in which the brush stops and discharges; 0: no brush"},
    {"brush", STUDY_REAL, &options.brush_middle, 90, 330, "deg", "its middle, clockwise from the top"},
    {"brush-half", STUDY_REAL, &options.brush_half, 1, 80, "deg", "half its angle"},
    {"scatter", STUDY_REAL, &options.scatter, 0, 1, "",
        "charges are multiplied by 1 - scatter times a random 0 to 1"},
    {"coulomb", STUDY_REAL, &options.coulomb, 0, 100, "mm", "range of forces between charged grains; 0: none"},
    {"near-interval", STUDY_REAL, &options.near_interval, 1e-3, 10, "ms", "from one list of pairs to the next"},
    {"touch", STUDY_REAL, &options.touch, 1e-3, 1000, "um", "gap up to which a grain touches the rotor"},
    {"at-contact", STUDY_REAL, &options.at_contact, 0, 1, "", "share of Q E that lifts metal off the rotor"},
    {"in-flight", STUDY_REAL, &options.in_flight, 0, 1, "", "share of Q E that acts on metal off the rotor"},
    {"in-front", STUDY_INT, &options.in_front, 0, 1, "", "1: metal takes its charge in the corona's window, without contact"},
    {"field-share", STUDY_REAL, &options.field_share, 0, 10, "", "factor on the electrode's field; .206: as the program of [CRI14]"},
    {"image-permittivity", STUDY_REAL, &options.image_permittivity, 1, 100, "", "er that divides the image force"},
    {"image", STUDY_INT, &options.image, 0, 1, "", "1: image force"},
    {"pull", STUDY_INT, &options.pull, 0, 1, "", "1: the field pulls ions' charge; 0: as [CRI14] has it"},
    {"drag", STUDY_CHOICE, &options.drag, 0, 0, "none|stokes|schiller|holzer", "of the air; holzer: depends on shape and attitude"},
    {"air-density", STUDY_REAL, &options.air_density, 0, 100, "kg/m3", ""},
    {"air-viscosity", STUDY_REAL, &options.air_viscosity, 1e-9, 1, "Pa s", ""},
    {"wind-x", STUDY_REAL, &options.wind_x, -30, 30, "m/s", "of the air"},
    {"wind-y", STUDY_REAL, &options.wind_y, -30, 30, "m/s", "of the air"},
    {"swirl", STUDY_REAL, &options.swirl, 0, 1, "",
        "speed of the air at the rotor over that of its surface"},
    {"bins", STUDY_REAL, &options.bins, -3, -0.17, "m", "height of the plane of the bins"},
    {"splitter-from", STUDY_REAL, &options.splitter_from, -1, 1, "m", "first of the 60 positions of the splitter"},
    {"setting", STUDY_CHOICE, &options.setting, 0, 0, "ours|seeds|springs", "how contacts are solved"},
    {"dt", STUDY_REAL, &options.dt, 0, 1e-2, "s", "step; 0: of the setting"},
    {"sweeps", STUDY_INT, &options.sweeps, 0, 100000, "", "at most, in a step; 0: of the setting"},
    {"cold", STUDY_INT, &options.cold, -1, 1, "", "1: sweeps begin with no impulses; -1: of the setting"},
    {"tolerance", STUDY_REAL, &options.tolerance, 0, 1, "m/s", "of impulses; 0: of the setting"},
    {"range", STUDY_REAL, &options.range, 0, 20, "mm", "gap from which impulses look; 0: of the setting"},
    {"cone", STUDY_CHOICE, &options.cone, 0, 0, "|coulomb|convex", "empty: of the setting"},
    {"solver", STUDY_CHOICE, &options.solver, 0, 0, "seidel|jacobi|apgd|spectral", "of impulses"},
    {"law", STUDY_CHOICE, &options.law, 0, 0, "hertz|linear", "of springs"},
    {"young", STUDY_REAL, &options.young, 1e4, 1e12, "Pa", "of springs"},
    {"threads", STUDY_INT, &options.threads, 0, 64, "", "0: as many as there are"},
    {"seed", STUDY_INT, &options.seed, 1, 1000000, "", "of the feed"},
    {"repeats", STUDY_INT, &options.repeats, 1, REPEATS, "", "runs of each value, with the seeds that follow"},
    {"quick", STUDY_FLAG, &options.quick, 0, 0, "", "less time, under 20 s"},
    {"short", STUDY_FLAG, &options.brief, 0, 0, "", STUDY_SHORT},
    {"check", STUDY_FLAG, &options.check, 0, 0, "", "equal bits for 1, 2, 3, 4, 8 threads and after a restart"},
    {"replay", STUDY_FLAG, &options.replay, 0, 0, "", "write replay.html, which a browser plays"},
    {"out", STUDY_TEXT, &options.out, 0, 0, "", "folder for results"},
    {"study", STUDY_CHOICE, &options.study, 0, 0, "run|feed|crowd|speed|voltage|distance|angle|middlings|mixture|sizes|shape|drag|settings|solvers|steps|choices|papers|load",
        "what to run"},
    {"values", STUDY_TEXT, &options.values, 0, 0, "", STUDY_VALUES},
    {"resume", STUDY_TEXT, &options.resume, 0, 0, "", "load: the file load.dem of an earlier run, whose stream is not run again"},
};
enum { OPTIONS = sizeof table/sizeof *table };

static int is(const char *a, const char *b) { return !strcmp(a, b); }

/* ---- the machine that the options describe ---- */

static separator_form form_of(const char *word) {
    return is(word, "flake") ? SEPARATOR_FLAKE : is(word, "shaving") ? SEPARATOR_SHAVING
        : is(word, "fragment") ? SEPARATOR_FRAGMENT : SEPARATOR_SPHERE;
}
static void part_add(separator_desc *d, separator_stuff stuff, separator_form form, double share) {
    separator_part *p = &d->parts[d->part_count];
    int i;
    if (!(share > 0)) return;
    for (i = 0; i < d->part_count; i++)
        if (d->parts[i].stuff == stuff && d->parts[i].form == form) { d->parts[i].share += share; return; }
    p->stuff = stuff; p->form = form; p->share = share;
    d->part_count++;
}
/* Sets the mixture that is fed. Returns 0, after a message, if the options contradict each other. */
static int mixture_set(separator_desc *d, const struct separator_options *o) {
    const double plastic = 1 - o->metal - o->middling;
    const separator_form metal_form = form_of(o->metal_form), plastic_form = form_of(o->plastic_form);
    d->part_count = 0;
    if (plastic < -1e-9) {
        study_fail("--metal %g and --middlings %g are %g of all together, must be at most 1; give less of one",
            o->metal,
                   o->middling, o->metal + o->middling);
        return 0;
    }
    part_add(d, SEPARATOR_METAL, metal_form, o->metal*(1 - o->mixed));
    part_add(d, SEPARATOR_METAL, SEPARATOR_SPHERE, o->metal*o->mixed);
    part_add(d, SEPARATOR_PLASTIC, plastic_form, plastic > 1e-9 ? plastic*(1 - o->mixed) : 0);
    if (o->middling > 0 && d->part_count == SEPARATOR_PARTS - 1 && o->mixed > 0 && plastic > 1e-9) {
        study_fail("--mixed %g with --middlings %g makes five kinds of grains, at most 4 are kept apart; leave one out",
                   o->mixed, o->middling);
        return 0;
    }
    part_add(d, SEPARATOR_PLASTIC, SEPARATOR_SPHERE, plastic > 1e-9 ? plastic*o->mixed : 0);
    part_add(d, SEPARATOR_MIDDLING, plastic_form, o->middling);
    return 1;
}
static int sizes_set(separator_desc *d, const struct separator_options *o) {
    const int zhang = is(o->sizes, "zhang"), weibull = is(o->sizes, "weibull");
    if (o->size_max < o->size_min || (zhang && !(o->size_mean > o->size_min))) {
        study_fail("--size-min %g, --size-mean %g and --size-max %g mm have to ascend (zhang: mean over min); raise %s",
                   o->size_min, o->size_mean, o->size_max, o->size_max < o->size_min ? "--size-max" : "--size-mean");
        return 0;
    }
    d->sizes.kind = zhang ? DEM_SIZES_EXPONENTIAL : weibull ? DEM_SIZES_WEIBULL : DEM_SIZES_UNIFORM;
    d->sizes.by_count = 1;
    d->sizes.min = (dem_real)(o->size_min/2000);
    d->sizes.scale = (dem_real)(o->size_mean/2000);
    d->sizes.max = (dem_real)(o->size_max/2000);
    d->sizes.modulus = weibull ? o->size_modulus : 0;
    return 1;
}
static void charging_set(separator_desc *d, const struct separator_options *o) {
    corona *c = &d->physics;
    const double degree = CORONA_PI/180, volts = 1000*o->voltage;
    c->strength = o->strength < 0 ? 11.818*fabs(volts) + 514.9 : o->strength;
    c->current = o->current;
    c->onset = corona_onset(o->rotor, o->wire/1000, o->wire_distance, 1, o->roughness);
    c->contact_time = o->contact_time; c->leak_time = o->leak_time; c->brush_time = o->brush_time;
    c->scatter = o->scatter;
    c->range = o->coulomb/1000;
    c->image = o->image; c->pull = o->pull;
    c->touch = 1e-6*o->touch;
    c->at_contact = o->at_contact; c->in_flight = o->in_flight; c->in_front = o->in_front;
    c->field_share = o->field_share; c->image_permittivity = o->image_permittivity;
    c->air_density = o->air_density; c->air_viscosity = o->air_viscosity;
    c->drag = is(o->drag, "none") ? CORONA_DRAG_NONE : is(o->drag, "stokes") ? CORONA_DRAG_STOKES
        : is(o->drag, "holzer") ? CORONA_DRAG_HOLZER : CORONA_DRAG_SCHILLER;
    c->wind[0] = o->wind_x; c->wind[1] = o->wind_y; c->swirl = o->swirl;
    d->ions_begin = o->ions_begin*degree; d->ions_end = o->ions_end*degree;
    d->brush_middle = o->brush_middle*degree; d->brush_half = o->brush_half*degree;
    d->layer = o->layer/1000;
}
static int fragments_fed(const struct separator_options *o) {
    return is(o->metal_form, "fragment") || is(o->plastic_form, "fragment");
}
/* Sets how contacts are solved: by the setting, then by further options. A fragment on the rotor spins at up to 1200 rad/s,
   and a step does not detect a corner that arrives during it. The overlap is then the corner's speed times dt, up to 0.9
   of the half width in 0.25 ms. */
static void setting_set(separator_desc *d, const struct separator_options *o) {
    const int seeds = is(o->setting, "seeds"), springs = is(o->setting, "springs");
    const int convex = *o->cone ? is(o->cone, "convex") : seeds;
    d->response = springs ? DEM_RESPONSE_SPRINGS : DEM_RESPONSE_IMPULSES;
    d->cone = convex ? DEM_CONE_CONVEX : DEM_CONE_COULOMB;
    d->solver = is(o->solver, "jacobi") ? DEM_SOLVER_JACOBI : is(o->solver, "apgd") ? DEM_SOLVER_APGD
        : is(o->solver, "spectral") ? DEM_SOLVER_SPECTRAL : DEM_SOLVER_GAUSS_SEIDEL;
    d->dt = o->dt > 0 ? o->dt : springs ? 0 : seeds ? 1e-3 : fragments_fed(o) ? 5e-5 : 2.5e-4;
    d->sweeps = o->sweeps ? o->sweeps : seeds ? 100 : 3000;  /* a full layer needs up to 1000 in some steps */
    d->tolerance = o->tolerance > 0 ? o->tolerance : seeds ? 1e-30 : 0;      /* all of the 100 */
    d->cold = o->cold < 0 ? seeds : o->cold;
    d->range = o->range > 0 ? o->range/1000 : 2e-3;
    d->young = o->young;
    d->normal_law = is(o->law, "linear") ? DEM_NORMAL_LINEAR : DEM_NORMAL_HERTZ;
}
static int desc_of(separator_desc *d, const struct separator_options *o) {
    *d = separator_desc_make();
    d->rotor = o->rotor; d->electrode = o->electrode; d->distance = o->distance;
    d->angle = o->angle*CORONA_PI/180; d->voltage = 1000*o->voltage; d->rpm = o->rpm;
    d->width = o->width; d->feed_width = o->feed_width; d->feed_time = o->seconds;
    d->rate = o->brief ? fmin(o->rate, 5000) : o->rate;      /* shapes in a crowd take minutes */
    d->feeder_speed = o->feeder_speed; d->feeder_angle = o->feeder_angle*CORONA_PI/180;
    d->feeder_length = o->feeder_length; d->feeder_edge = o->feeder_edge; d->near_interval = o->near_interval/1000;
    d->density[SEPARATOR_METAL] = o->density_metal; d->density[SEPARATOR_PLASTIC] = o->density_plastic;
    d->permittivity = o->permittivity; d->middling = o->middling_metal;
    d->restitution = o->restitution; d->friction = o->friction; d->drum_friction = o->drum_friction;
    d->plate_friction = o->plate_friction; d->rolling = o->rolling;
    d->bins = o->bins; d->threads = o->threads; d->seed = (uint64_t)o->seed;
    charging_set(d, o);
    setting_set(d, o);
    if (!(o->distance > o->rotor + o->electrode + 2e-3*o->size_max)) {
        study_fail("--distance is %g m, must be more than both radii and a grain, %g m, or the two touch; raise it",
                   o->distance, o->rotor + o->electrode + 2e-3*o->size_max);
        return 0;
    }
    if (!(o->wire_distance > o->rotor + o->wire/1000)) {
        study_fail("--wire-distance is %g m, must be more than --rotor and --wire, %g m: it lies in the rotor; raise "
                   "it", o->wire_distance, o->rotor + o->wire/1000);
        return 0;
    }
    if (!(o->ions_end > o->ions_begin)) {
        study_fail("--ions-end is %g deg, must be more than --ions-begin, %g deg; swap them", o->ions_end,
            o->ions_begin);
        return 0;
    }
    if (o->bins > -o->rotor - 0.005) {
        study_fail("--bins is %g m, must be below the rotor, %g m; lower it", o->bins, -o->rotor - 0.005);
        return 0;
    }
    return mixture_set(d, o) && sizes_set(d, o);
}

/* ---- results of a run ---- */

typedef struct outcome {
    char name[GROUPS][32];             /* names of the groups: the stuffs, then the parts of stuffs that have two forms */
    double count[GROUPS], mass[GROUPS], mean[GROUPS], sd[GROUPS], brushed[GROUPS], bins[GROUPS][BINS];
    double purity[SPLITTERS], recovery[SPLITTERS], best, quality;    /* shares; m */
    double beyond[3][SPLITTERS];       /* kg of each stuff beyond the splitters */
    double sweeps, residual, unsolved, overlap, steps, compute, grain_steps, fed, binned, present, unbalanced;
    int impulses;                      /* 1: overlaps are checked; the steps of the papers are too long for that */
} outcome;

static const char *const stuff_names[3] = {"metal", "plastic", "middling"};
static const char *const form_names[4] = {"sphere", "flake", "shaving", "fragment"};

static double splitter_place(const struct separator_options *o, int i) {
    return o->splitter_from + 0.2*i/(SPLITTERS - 1);
}
/* Returns the fraction of a part's mass that is metal. */
static double metal_share(const separator_desc *d, separator_stuff stuff) {
    const double f = d->middling*d->density[SEPARATOR_METAL];
    return stuff == SEPARATOR_METAL ? 1 : stuff == SEPARATOR_PLASTIC ? 0
        : f/(f + (1 - d->middling)*d->density[SEPARATOR_PLASTIC]);
}
static void group_names(const separator_desc *d, outcome *r) {
    int i, k, forms[3] = {0, 0, 0};
    for (i = 0; i < d->part_count; i++) forms[d->parts[i].stuff]++;
    for (k = 0; k < 3; k++) if (forms[k]) snprintf(r->name[k], sizeof r->name[k], "%s", stuff_names[k]);
    for (i = 0; i < d->part_count; i++)
        if (forms[d->parts[i].stuff] > 1)
            snprintf(r->name[3 + i], sizeof r->name[0], "%s.%s", stuff_names[d->parts[i].stuff],
                form_names[d->parts[i].form]);
}
static void landing_count(const separator *s, outcome *r, int g, const separator_landing *l) {
    const int bin = (int)floor((l->x - bin_first)/bin_wide);
    r->count[g]++;
    r->mass[g] += l->mass;
    r->mean[g] += l->mass*l->x;
    r->sd[g] += l->mass*l->x*l->x;
    r->brushed[g] += l->x < -s->desc.rotor/2 ? l->mass : 0;
    if (bin >= 0 && bin < BINS) r->bins[g][bin] += l->mass;
}
static void splitters_take(const separator *s, const struct separator_options *o, outcome *r) {
    int i, k;
    r->quality = -1;
    for (i = 0; i < s->landed_count; i++)
        for (k = 0; k < SPLITTERS && s->landed[i].x >= splitter_place(o, k); k++)
            r->beyond[s->desc.parts[s->landed[i].part].stuff][k] += s->landed[i].mass;
    for (k = 0; k < SPLITTERS; k++) {
        double beyond = 0, metal = 0, all = 0;
        for (i = 0; i < s->landed_count; i++) {
            const separator_landing *l = &s->landed[i];
            const double of_metal = l->mass*metal_share(&s->desc, s->desc.parts[l->part].stuff);
            all += of_metal;
            if (l->x < splitter_place(o, k)) continue;
            beyond += l->mass;
            metal += of_metal;
        }
        r->purity[k] = beyond > 0 ? metal/beyond : 1;        /* an empty bin counts as pure */
        r->recovery[k] = all > 0 ? metal/all : 0;
        if (r->purity[k] + r->recovery[k] - 1 > r->quality) {
            r->quality = r->purity[k] + r->recovery[k] - 1;
            r->best = splitter_place(o, k);
        }
    }
}
/* Three products: plastic before the splitter `near`, middlings from there to `far`, metal beyond. Returns the purity of one,
   0 if its bin is empty, and its recovery: shares of the mass of its own stuff, middlings being a stuff of their own. */
static double product_get(const outcome *r, int stuff, int near, int far, double *recovery) {
    double own = 0, all = 0;
    int g;
    for (g = 0; g < 3; g++) {
        const double mass = stuff == SEPARATOR_METAL ? r->beyond[g][far]
            : stuff == SEPARATOR_MIDDLING ? r->beyond[g][near] - r->beyond[g][far] : r->mass[g] - r->beyond[g][near];
        all += mass;
        if (g == stuff) own = mass;
    }
    *recovery = r->mass[stuff] > 0 ? own/r->mass[stuff] : 0;
    return all > 1e-12 ? own/all : 0;
}
/* Returns the mean over the three products of purity + recovery - 1. */
static double products_quality(const outcome *r, int near, int far) {
    double sum = 0, recovery;
    int g;
    for (g = 0; g < 3; g++) sum += product_get(r, g, near, far, &recovery) + recovery - 1;
    return sum/3;
}
static void products_best(const outcome *r, int *near, int *far) {
    double most = -1;
    int a, b;
    *near = *far = 0;
    for (a = 0; a < SPLITTERS; a++)
        for (b = a; b < SPLITTERS; b++)
            if (products_quality(r, a, b) > most) { most = products_quality(r, a, b); *near = a; *far = b; }
}
static void outcome_take(const separator *s, const struct separator_options *o, outcome *r) {
    const dem_counters c = dem_counters_get(s->world);
    dem_feed_state fed;
    int i, g;
    group_names(&s->desc, r);
    for (i = 0; i < s->landed_count; i++) {
        landing_count(s, r, (int)s->desc.parts[s->landed[i].part].stuff, &s->landed[i]);
        landing_count(s, r, 3 + s->landed[i].part, &s->landed[i]);
    }
    for (g = 0; g < GROUPS; g++) {
        if (!(r->mass[g] > 0)) continue;
        r->mean[g] /= r->mass[g];
        r->sd[g] = sqrt(fmax(0, r->sd[g]/r->mass[g] - r->mean[g]*r->mean[g]));
        r->brushed[g] /= r->mass[g];
    }
    splitters_take(s, o, r);
    memset(&fed, 0, sizeof fed);
    dem_feed_get(s->world, s->feed, &fed);
    r->fed = (double)fed.total;
    r->binned = s->landed_count;
    r->present = (double)separator_present(s);
    r->unbalanced = (double)s->unbalanced;
    r->sweeps = s->steps ? s->sweeps/(double)s->steps : 0;
    r->residual = s->residual_max;
    r->unsolved = (double)c.unsolved;
    r->overlap = (double)c.overlap_max;
    r->impulses = s->desc.response == DEM_RESPONSE_IMPULSES && s->desc.cone == DEM_CONE_COULOMB;
    r->steps = (double)c.steps;
}
static void outcome_tell(const outcome *r, int splitters) {
    char text[64];
    int g, k;
    for (g = 0; g < GROUPS; g++) {
        if (!*r->name[g] || !(r->mass[g] > 0)) continue;
#define TELL(what, value, unit) snprintf(text, sizeof text, "%s." what, r->name[g]); study_result(text, value, unit)
        TELL("x_mean", r->mean[g], "m");
        TELL("x_sd", r->sd[g], "m");
        TELL("landed", r->count[g], "");
        TELL("brushed", r->brushed[g], "");
#undef TELL
    }
    for (k = 0; k < SPLITTERS && splitters; k++) {
        snprintf(text, sizeof text, "splitter%02d.purity", k);
        study_result(text, 100*r->purity[k], "%");
        snprintf(text, sizeof text, "splitter%02d.recovery", k);
        study_result(text, 100*r->recovery[k], "%");
    }
    study_result("best_splitter", r->best, "m");
    study_result("best_quality", 100*r->quality, "%");
    study_result("sweeps_mean", r->sweeps, "");
    study_result("residual_max", r->residual, "m/s");
    study_result("unsolved_steps", r->unsolved, "");
    study_result("overlap_max", r->overlap, "");
    study_result("fed", r->fed, "");
    study_result("binned", r->binned, "");
    study_result("present", r->present, "");
    study_result("missing", r->fed - r->binned - r->present, "");
    study_result("unbalanced_steps", r->unbalanced, "");
    study_result("steps", r->steps, "");
    study_result("compute", r->compute, "s");
    study_result("grain_steps", r->grain_steps, "1/s");
    if (r->impulses && r->overlap > 0.5)
        study_fail("grains overlap by %g of their half width, must be at most 0.5: their corners turn too far in a step, or "
                   "there are too many for the sweeps; use half of the --dt of this run, or a lower --rate", r->overlap);
    if (r->unbalanced > 0 || r->fed > r->binned + r->present || r->fed < r->binned + r->present)
        study_fail("grains are missing");
}

/* ---- one run ---- */

static double grain_charge(const dem_world *world, dem_body body, void *user) {
    dem_body_state s;
    (void)user;
    if (dem_body_get(world, body, &s) != DEM_OK || !s.reals) return 0;
    return 1e12*((double)s.reals[CORONA_INDUCED] + (double)s.reals[CORONA_IONS]);
}
/* Draws the present grains, coloured by charge, with rotor, electrode and plate. */
static void picture_draw(const separator *s, const char *file) {
    enum { RIM = 121 };
    const dem_bodies b = dem_bodies_get(s->world);
    double *v[4], rim[2][2][RIM], plate[2][3];
    study_figure f;
    int i, k, n = 0;
    memset(&f, 0, sizeof f);
    for (k = 0; k < 4; k++) v[k] = (double *)study_alloc((size_t)b.count + 1, sizeof(double));
    for (i = 0; i < b.count; i++) {
        const dem_real *x = b.positions + 4*i, *reals = b.reals + b.real_count*i;
        if ((double)x[1] < s->desc.bins) continue;
        v[0][n] = (double)x[0];
        v[1][n] = (double)x[1];
        v[2][n] = 2.5*(double)x[3];                /* enlarged, so that they can be seen */
        v[3][n++] = 1e12*((double)reals[CORONA_INDUCED] + (double)reals[CORONA_IONS]);
    }
    for (i = 0; i < RIM; i++) {
        const double a = 2*CORONA_PI*i/(RIM - 1);
        rim[0][0][i] = s->desc.rotor*cos(a);
        rim[0][1][i] = s->desc.rotor*sin(a);
        rim[1][0][i] = s->desc.distance*cos(s->desc.angle) + s->desc.electrode*cos(a);
        rim[1][1][i] = s->desc.distance*sin(s->desc.angle) + s->desc.electrode*sin(a);
    }
    plate[0][1] = plate[0][0] = s->desc.feeder_edge - s->desc.feeder_length*cos(s->desc.feeder_angle);
    plate[0][2] = s->desc.feeder_edge;
    plate[1][2] = s->desc.rotor + 0.004;
    plate[1][1] = plate[1][2] + s->desc.feeder_length*sin(s->desc.feeder_angle);
    plate[1][0] = plate[1][1] + 0.04;
    study_curve(&f, 0, STUDY_OUTLINE, RIM, rim[0][0], rim[0][1]);
    study_curve(&f, 0, STUDY_OUTLINE, RIM, rim[1][0], rim[1][1]);
    study_curve(&f, 0, STUDY_OUTLINE, 3, plate[0], plate[1]);
    f.title = "Grains in the separator, drawn 2.5 times as large";
    f.x_label = "x [m]"; f.y_label = "y [m]"; f.bar_label = "charge [pC]";
    f.equal = 1;
    f.size = 620;
    f.x0 = -0.3; f.x1 = 0.45; f.y0 = s->desc.bins - 0.02; f.y1 = 0.26;
    f.lo = -40; f.hi = 40;
    f.disc_count = n;
    f.disc_x = v[0]; f.disc_y = v[1]; f.disc_r = v[2]; f.disc_value = v[3];
    study_figure_write(&f, file);
    for (k = 0; k < 4; k++) free(v[k]);
}
/* Makes one run: feeds, lets grains land, counts. picture: drawn half way. Returns 0 on success; the caller ends s. */
static int separator_run(separator *s, const struct separator_options *o, const char *name, outcome *r,
    const char *picture) {
    separator_desc d;
    study_replay f;
    const double all = o->seconds + (o->brief && is(o->setting, "springs") ? 0 : o->drain);
    double begun, work = 0, steps = 0;
    dem_result result;
    int drawn = !picture;
    memset(r, 0, sizeof *r);
    memset(s, 0, sizeof *s);
    if (!desc_of(&d, o)) return 1;
    if (separator_create(s, &d) != DEM_OK) { study_fail("%s", s->error); return 1; }
    f = study_replay_open_by(s->world, o->replay ? 240 : 0, o->seconds, "A corona electrostatic separator", "charge_pC",
        grain_charge);
    begun = study_clock();
    for (;;) {
        const double now = dem_world_time_get(s->world);
        const int count = dem_bodies_get(s->world).count;
        if (now > all || (now > o->seconds && !separator_present(s))) break;
        result = separator_step(s);
        if (result != DEM_OK) { study_fail("%s", s->error); study_replay_close(&f); return 1; }
        work += count*((double)dem_counters_get(s->world).steps - steps);
        steps = (double)dem_counters_get(s->world).steps;
        if (!drawn && 2*now >= o->seconds) { picture_draw(s, picture); drawn = 1; }
        if (study_replay_due(&f)) {
            study_replay_value(&f, "grains present", count);
            study_replay_value(&f, "grains landed", s->landed_count);
            study_replay_frame(&f);
        }
        study_progress(name, fmin(1, now/all), work);
    }
    study_progress(name, 1, work);
    r->compute = study_clock() - begun;
    r->grain_steps = work/fmax(r->compute, 1e-9);
    study_replay_close(&f);
    outcome_take(s, o, r);
    return 0;
}

/* ---- pictures ---- */

/* Draws a histogram as steps: % of the group's mass per bin. */
static void steps_draw(const double *bins, double mass, double *x, double *y) {
    int i;
    for (i = 0; i < BINS; i++) {
        x[2*i] = bin_first + i*bin_wide;
        x[2*i + 1] = bin_first + (i + 1)*bin_wide;
        y[2*i] = y[2*i + 1] = mass > 0 ? 100*bins[i]/mass : 0;
    }
}
/* Sets the range of the figure to the bins that are not empty. */
static void range_widen(study_figure *f, const outcome *r, int g) {
    int i;
    for (i = 0; i < BINS && r->mass[g] > 0; i++) {
        const double x = bin_first + i*bin_wide;
        if (r->bins[g][i] < 1e-3*r->mass[g]) continue;
        if (f->x0 >= f->x1) { f->x0 = x - bin_wide; f->x1 = x + 2*bin_wide; }
        if (x - bin_wide < f->x0) f->x0 = x - bin_wide;
        if (x + 2*bin_wide > f->x1) f->x1 = x + 2*bin_wide;
    }
}
static void distribution_draw(const outcome *r) {
    double x[GROUPS][2*BINS], y[GROUPS][2*BINS];
    study_figure f;
    int g;
    memset(&f, 0, sizeof f);
    f.title = "Where grains land";
    f.x_label = "x at the bins [m]"; f.y_label = "share of its mass [% per 5 mm]";
    for (g = 0; g < GROUPS; g++) {
        if (!*r->name[g] || !(r->mass[g] > 0)) continue;
        steps_draw(r->bins[g], r->mass[g], x[g], y[g]);
        range_widen(&f, r, g);
        study_curve(&f, r->name[g], g < 3 ? STUDY_LINE : STUDY_DASHED, 2*BINS, x[g], y[g]);
    }
    study_figure_write(&f, "distribution.svg");
}
static void splitter_draw(const struct separator_options *o, const outcome *r) {
    double x[SPLITTERS], p[SPLITTERS], q[SPLITTERS];
    study_figure f;
    int k;
    memset(&f, 0, sizeof f);
    for (k = 0; k < SPLITTERS; k++) { x[k] = splitter_place(o, k); p[k] = 100*r->purity[k]; q[k] = 100*r->recovery[k]; }
    f.title = "Metal beyond the splitter";
    f.x_label = "splitter [m]"; f.y_label = "%";
    f.y0 = 0; f.y1 = 105;
    study_curve(&f, "purity", STUDY_LINE, SPLITTERS, x, p);
    study_curve(&f, "recovery", STUDY_LINE, SPLITTERS, x, q);
    study_figure_write(&f, "splitter.svg");
}
static void tables_write(const struct separator_options *o, const outcome *r) {
    double x[BINS], place[SPLITTERS];
    const double *bins[4], *splitters[3];
    int i;
    for (i = 0; i < BINS; i++) x[i] = bin_first + (i + 0.5)*bin_wide;
    for (i = 0; i < SPLITTERS; i++) place[i] = splitter_place(o, i);
    bins[0] = x;
    for (i = 0; i < 3; i++) bins[i + 1] = r->bins[i];
    splitters[0] = place; splitters[1] = r->purity; splitters[2] = r->recovery;
    study_csv("bins.csv", "x_m,metal_kg,plastic_kg,middling_kg", BINS, 4, bins);
    study_csv("splitter.csv", "splitter_m,purity,recovery", SPLITTERS, 3, splitters);
}

/* Draws maps over both splitters, of the quality of all products and of purity and recovery of the middlings, and curves of
   metal and plastic, which one splitter decides. NAME_products.csv has the numbers. */
static void products_draw(const struct separator_options *o, const outcome *r, const char *name) {
    static const char *const titles[3] = {"Quality of three products [%]", "Purity of middlings [%]", "Recovery of middlings [%]"};
    static const char *const files[3] = {"quality", "purity", "recovery"};
    static double map[3][SPLITTERS*SPLITTERS];
    double x[SPLITTERS], curve[4][SPLITTERS], recovery;
    const double first = 1000*splitter_place(o, 0), last = 1000*splitter_place(o, SPLITTERS - 1);
    char file[96];
    study_figure f;
    FILE *csv;
    int a, b, k, g;
    snprintf(file, sizeof file, "%s%sproducts.csv", name, *name ? "_" : "");
    csv = study_open(file);
    if (csv) fputs("near_m,far_m,plastic_purity,plastic_recovery,middling_purity,middling_recovery,metal_purity,metal_recovery\n", csv);
    for (a = 0; a < SPLITTERS; a++)
        for (b = 0; b < SPLITTERS; b++) {
            const int at = SPLITTERS*b + a;
            for (k = 0; k < 3; k++) map[k][at] = nan("");
            if (b < a) continue;
            map[0][at] = 100*products_quality(r, a, b);
            map[1][at] = 100*product_get(r, SEPARATOR_MIDDLING, a, b, &recovery);
            map[2][at] = 100*recovery;
            if (csv) fprintf(csv, "%.6g,%.6g", splitter_place(o, a), splitter_place(o, b));
            for (g = 1; g < 4 && csv; g++) {
                const double purity = product_get(r, g == 1 ? SEPARATOR_PLASTIC : g == 2 ? SEPARATOR_MIDDLING : SEPARATOR_METAL,
                                                  a, b, &recovery);
                fprintf(csv, ",%.6g,%.6g%s", purity, recovery, g == 3 ? "\n" : "");
            }
        }
    if (csv) study_close(csv, file);
    for (k = 0; k < 3; k++) {
        memset(&f, 0, sizeof f);
        f.title = titles[k];
        f.x_label = "splitter of plastic and middlings [mm]"; f.y_label = "splitter of middlings and metal [mm]";
        f.equal = 1;
        f.size = 480;
        f.x0 = f.y0 = first; f.x1 = f.y1 = last;
        f.nx = f.ny = SPLITTERS;
        f.value = map[k];
        f.hi = 100;
        snprintf(file, sizeof file, "%s%sproducts_%s.svg", name, *name ? "_" : "", files[k]);
        study_figure_write(&f, file);
    }
    memset(&f, 0, sizeof f);
    f.title = "Products that one splitter decides";
    f.x_label = "splitter [mm]"; f.y_label = "%";
    f.y1 = 105;
    for (a = 0; a < SPLITTERS; a++) {
        x[a] = 1000*splitter_place(o, a);
        curve[0][a] = 100*product_get(r, SEPARATOR_METAL, a, a, &recovery);
        curve[1][a] = 100*recovery;
        if (!(recovery > 0)) curve[0][a] = nan("");            /* an empty bin */
        curve[2][a] = 100*product_get(r, SEPARATOR_PLASTIC, a, a, &recovery);
        curve[3][a] = 100*recovery;
        if (!(recovery > 0)) curve[2][a] = nan("");
    }
    study_curve(&f, "metal, purity", STUDY_LINE, SPLITTERS, x, curve[0]);
    study_curve(&f, "metal, recovery", STUDY_DASHED, SPLITTERS, x, curve[1]);
    study_curve(&f, "plastic, purity", STUDY_LINE, SPLITTERS, x, curve[2]);
    study_curve(&f, "plastic, recovery", STUDY_DASHED, SPLITTERS, x, curve[3]);
    snprintf(file, sizeof file, "%s%sproducts_ends.svg", name, *name ? "_" : "");
    study_figure_write(&f, file);
}

/* ---- sweeps: some values, each with some seeds ---- */

typedef struct sweep {
    const char *name, *title, *label;
    int count;
    double value[VALUES];
    const char *words[VALUES];         /* names instead of numbers; the values are then 0, 1, 2 ... */
    void (*set)(struct separator_options *o, double value);
} sweep;
static void set_rate(struct separator_options *o, double v) { o->rate = v; }
static void set_rpm(struct separator_options *o, double v) { o->rpm = v; }
static void set_voltage(struct separator_options *o, double v) { o->voltage = v; }
/* Spheres, flakes and shavings, each with a drag of spheres and with one of their shape. */
static void set_drag(struct separator_options *o, double value) {
    o->metal_form = o->plastic_form = form_names[(int)value/2];
    o->drag = (int)value%2 ? "holzer" : "schiller";
}
static void set_form(struct separator_options *o, double v) { o->metal_form = o->plastic_form = form_names[(int)v]; }
static void set_setting(struct separator_options *o, double v) {
    static const char *const words[3] = {"ours", "seeds", "springs"};
    o->setting = words[(int)v];
}
static void set_dt(struct separator_options *o, double v) { o->dt = 1e-3*v; }
/* Feeds at least as many grains as in --seconds at 20,000 a second. */
static void set_crowd(struct separator_options *o, double v) { o->rate = v; o->seconds *= fmax(1, 20000/v); }
static void set_distance(struct separator_options *o, double v) { o->distance = v; }
static void set_angle(struct separator_options *o, double v) { o->angle = v; }
static void set_middling(struct separator_options *o, double v) {
    o->metal = 0.3; o->middling = 0.1;
    o->middling_metal = v;
}
static void set_mixture(struct separator_options *o, double v) { o->metal = v; }
static void set_size(struct separator_options *o, double v) { o->size_mean = v; }
static void set_solver(struct separator_options *o, double v) {
    static const char *const words[4] = {"seidel", "jacobi", "apgd", "spectral"};
    o->solver = words[(int)v];
}
/* The physics of the papers: each change alone, then all together, then with the weaker field of their program as well. */
static void set_papers(struct separator_options *o, double v) {
    const int n = (int)v, all = n >= 9;
    if (n == 1 || all) o->setting = "seeds";
    if (n == 2 || all) o->drag = "stokes";
    if (n == 3 || all) o->coulomb = 0;
    if (n == 4 || all) o->pull = 0;
    if (n == 5 || all) o->current = 0;
    if (n == 6 || all) { o->in_front = 1; o->in_flight = 0.832; }
    if (n == 7 || all) o->contact_time = 0;
    if (n == 8 || all) o->image_permittivity = o->permittivity;
    if (n == 10) o->field_share = 0.206;
}
static void set_choice(struct separator_options *o, double v) {
    switch ((int)v) {
    case 1: o->rolling = 1; break;
    case 2: o->strength = 0; break;
    case 3: o->strength = 1e6; o->current = 0; break;
    case 4: o->pull = 0; break;
    case 5: o->coulomb = 0; break;
    case 6: o->drag = "stokes"; break;
    case 7: o->swirl = 1; break;
    default: break;
    }
}
static const sweep sweeps[] = {
    {"feed", "Feed rate", "feed [grains/s]", 4, {1000, 3000, 10000, 20000}, {0}, set_rate},
    {"crowd", "Feed rate, as many grains at each", "feed [grains/s]", 6, {100, 1000, 3000, 10000, 20000, 35000}, {0}, set_crowd},
    {"speed", "Rotor speed", "rotor [1/min]", 6, {25, 35, 45, 55, 65, 80}, {0}, set_rpm},
    {"voltage", "Voltage", "electrode [kV]", 6, {0, 10, 20, 25, 30, 35}, {0}, set_voltage},
    {"distance", "Distance of the electrode", "between the axes [m]", 5, {0.21, 0.235, 0.267, 0.3, 0.35}, {0}, set_distance},
    {"angle", "Angle of the electrode", "above the horizontal [deg]", 6, {0, 15, 30, 45, 60, 75}, {0}, set_angle},
    {"middlings", "Share of metal in middlings", "share by volume", 5, {0.1, 0.3, 0.5, 0.7, 0.9}, {0}, set_middling},
    {"mixture", "Share of metal in the feed", "share by number", 5, {0.1, 0.3, 0.5, 0.7, 0.9}, {0}, set_mixture},
    {"sizes", "Mean size", "mean diameter [mm]", 5, {1.2, 1.5, 2, 2.5, 3}, {0}, set_size},
    {"shape", "Shape", "0 sphere, 1 flake, 2 shaving, 3 fragment", 4, {0, 1, 2, 3},
        {"sphere", "flake", "shaving", "fragment"}, set_form},
    {"drag", "Drag by shape", "0 sphere, 2 flake, 4 shaving; + 1: drag depends on shape", 6, {0, 1, 2, 3, 4, 5},
        {"sphere.schiller", "sphere.holzer", "flake.schiller", "flake.holzer", "shaving.schiller", "shaving.holzer"}, set_drag},
    {"settings", "Contacts", "0 ours, 1 seeds, 2 springs", 3, {0, 1, 2}, {"ours", "seeds", "springs"}, set_setting},
    {"solvers", "Solvers", "0 Gauss-Seidel, 1 Jacobi, 2 accelerated, 3 spectral", 4, {0, 1, 2, 3},
        {"seidel", "jacobi", "apgd", "spectral"}, set_solver},
    {"papers", "Physics of the papers", "change, as in the table", 11, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10},
        {"chosen", "setting", "stokes", "no_coulomb", "no_pull", "at_once", "in_front", "discharge", "image_er", "all",
         "all_weak_field"}, set_papers},
    {"steps", "Step", "step [ms]", 5, {0.05, 0.1, 0.25, 0.5, 1}, {0}, set_dt},
    {"choices", "Choices", "choice, as in the table", 8, {0, 1, 2, 3, 4, 5, 6, 7},
        {"chosen", "rolling1", "strength0", "pinned", "no_pull", "no_coulomb", "stokes", "swirl1"}, set_choice},
};
typedef struct spread { double mean, error; } spread;
static spread spread_of(const double *value, int count) {
    spread s;
    s.mean = study_mean(value, count, 1, &s.error);
    if (count < 2) s.error = 0;
    return s;
}
static void spread_tell(const char *group, const char *what, spread s, const char *unit) {
    char text[96];
    snprintf(text, sizeof text, "%s%s%s", group, *group ? "." : "", what);
    study_result(text, s.mean, unit);
    snprintf(text, sizeof text, "%s%s%s_error", group, *group ? "." : "", what);
    study_result(text, s.error, unit);
}

/* The results of a sweep: for each value means and standard errors. */
typedef struct swept { outcome mean; spread x[3], sd[3], quality, compute; char name[32]; } swept;
static outcome trials[REPEATS];
static swept kept[VALUES];

static void outcome_add(outcome *sum, const outcome *r, double share) {
    int g, k;
    memcpy(sum->name, r->name, sizeof sum->name);
    for (g = 0; g < 3; g++)
        for (k = 0; k < SPLITTERS; k++) sum->beyond[g][k] += share*r->beyond[g][k];
    for (g = 0; g < GROUPS; g++) {
        sum->mass[g] += share*r->mass[g];
        for (k = 0; k < BINS; k++) sum->bins[g][k] += share*r->bins[g][k];
    }
    for (k = 0; k < SPLITTERS; k++) {
        sum->purity[k] += share*r->purity[k];
        sum->recovery[k] += share*r->recovery[k];
    }
}
/* Reports the three products at the two splitters that are best for all seeds together. */
static void products_tell(const outcome *mean, const struct separator_options *o, int repeats) {
    double number[3][REPEATS];
    int near, far, g, i;
    char text[48];
    products_best(mean, &near, &far);
    study_result("products.near_splitter", splitter_place(o, near), "m");
    study_result("products.far_splitter", splitter_place(o, far), "m");
    for (g = 0; g < 3; g++) {
        for (i = 0; i < repeats; i++) {
            number[0][i] = 100*product_get(&trials[i], g, near, far, &number[1][i]);
            number[1][i] *= 100;
            number[2][i] = 100*products_quality(&trials[i], near, far);
        }
        snprintf(text, sizeof text, "products.%s", stuff_names[g]);
        spread_tell(text, "purity", spread_of(number[0], repeats), "%");
        spread_tell(text, "recovery", spread_of(number[1], repeats), "%");
    }
    spread_tell("products", "quality", spread_of(number[2], repeats), "%");
}
static void value_tell(swept *v, const struct separator_options *base, int repeats) {
    double number[REPEATS];
    int g, i;
    memset(&v->mean, 0, sizeof v->mean);
    for (i = 0; i < repeats; i++) outcome_add(&v->mean, &trials[i], 1.0/repeats);
    for (g = 0; g < 3; g++) {
        if (!(v->mean.mass[g] > 0)) continue;
        for (i = 0; i < repeats; i++) number[i] = trials[i].mean[g];
        spread_tell(stuff_names[g], "x_mean", v->x[g] = spread_of(number, repeats), "m");
        for (i = 0; i < repeats; i++) number[i] = trials[i].sd[g];
        spread_tell(stuff_names[g], "x_sd", v->sd[g] = spread_of(number, repeats), "m");
        for (i = 0; i < repeats; i++) number[i] = trials[i].brushed[g];
        spread_tell(stuff_names[g], "brushed", spread_of(number, repeats), "");
    }
    for (i = 0; i < repeats; i++) number[i] = 100*trials[i].quality;
    spread_tell("", "best_quality", v->quality = spread_of(number, repeats), "%");
    for (i = 0; i < repeats; i++) number[i] = trials[i].best;
    spread_tell("", "best_splitter", spread_of(number, repeats), "m");
    if (v->mean.mass[SEPARATOR_MIDDLING] > 0) products_tell(&v->mean, base, repeats);
    for (i = 0; i < repeats; i++) number[i] = trials[i].compute;
    spread_tell("", "compute", v->compute = spread_of(number, repeats), "s");
}
/* Runs all seeds of one value; returns 0 on success. */
static int value_run(const struct separator_options *base, const char *name, swept *v) {
    static separator s;
    int i, bad = 0;
    snprintf(v->name, sizeof v->name, "%s", name);
    for (i = 0; i < base->repeats && !bad; i++) {
        struct separator_options o = *base;
        o.seed += i;
        snprintf(study.prefix, sizeof study.prefix, "%s.seed%d.", name, o.seed);
        bad = separator_run(&s, &o, name, &trials[i], 0);
        if (!bad) outcome_tell(&trials[i], 0);
        separator_end(&s);
    }
    snprintf(study.prefix, sizeof study.prefix, "%s.", name);
    if (!bad) value_tell(v, base, base->repeats);
    if (!bad && v->mean.mass[SEPARATOR_MIDDLING] > 0) products_draw(base, &v->mean, name);
    study.prefix[0] = 0;
    return bad;
}
/* A curve through means, and upright bars of one standard error: three points of each, the last a gap. */
typedef struct barred { double x[VALUES], y[VALUES], bar_x[3*VALUES], bar_y[3*VALUES]; } barred;
static void barred_draw(study_figure *f, barred *b, const char *name, const double *value, const spread *s,
    size_t stride,
                        int count) {
    int i;
    for (i = 0; i < count; i++) {
        const spread *at_i = (const spread *)(const void *)((const char *)s + stride*(size_t)i);
        b->x[i] = b->bar_x[3*i] = b->bar_x[3*i + 1] = b->bar_x[3*i + 2] = value[i];
        b->y[i] = at_i->mean;
        b->bar_y[3*i] = at_i->mean - at_i->error;
        b->bar_y[3*i + 1] = at_i->mean + at_i->error;
        b->bar_y[3*i + 2] = nan("");
    }
    study_curve(f, name, STUDY_LINE, count, b->x, b->y);
    study_curve(f, 0, STUDY_OUTLINE, 3*count, b->bar_x, b->bar_y);
}
static void sweep_means_draw(const sweep *w, const double *value, int count) {
    static barred b[7];
    char file[64];
    study_figure f[3];
    int g, k;
    memset(f, 0, sizeof f);
    f[0].title = "Where the middle of each lands"; f[0].y_label = "x at the bins [m]";
    f[1].title = "How wide each is spread"; f[1].y_label = "standard deviation of x [m]";
    f[2].title = "Quality at the best splitter"; f[2].y_label = "purity + recovery - 100 [%]";
    for (k = 0; k < 3; k++) {
        static const char *const names[3] = {"mean", "sd", "quality"};
        const double room = 0.05*(value[count - 1] - value[0]);
        f[k].x_label = w->label;
        f[k].x0 = value[0] - room; f[k].x1 = value[count - 1] + room;
        for (g = 0; g < 3 && k < 2; g++)
            if (kept[0].mean.mass[g] > 0)
                barred_draw(&f[k], &b[3*k + g], stuff_names[g], value, k ? &kept[0].sd[g] : &kept[0].x[g],
                            sizeof *kept, count);
        if (k == 2) barred_draw(&f[k], &b[6], "best", value, &kept[0].quality, sizeof *kept, count);
        snprintf(file, sizeof file, "%s_%s.svg", w->name, names[k]);
        study_figure_write(&f[k], file);
    }
}
static void sweep_curves_draw(const sweep *w, const struct separator_options *o, int count) {
    static double x[2][VALUES][2*BINS], y[2][VALUES][2*BINS], place[SPLITTERS], share[2][VALUES][SPLITTERS];
    static const char *const names[4] = {"metal", "plastic", "purity", "recovery"};
    char file[64], title[96];
    study_figure f[4];
    int i, k, g;
    memset(f, 0, sizeof f);
    for (k = 0; k < SPLITTERS; k++) place[k] = splitter_place(o, k);
    for (g = 0; g < 4; g++) {
        f[g].x_label = g < 2 ? "x at the bins [m]" : "splitter [m]";
        f[g].y_label = g < 2 ? "share of its mass [% per 5 mm]" : "%";
        for (i = 0; i < count; i++) {
            const outcome *r = &kept[i].mean;
            if (g < 2) {
                steps_draw(r->bins[g], r->mass[g], x[g][i], y[g][i]);
                range_widen(&f[g], r, g);
                study_curve(&f[g], kept[i].name, STUDY_LINE, 2*BINS, x[g][i], y[g][i]);
                continue;
            }
            for (k = 0; k < SPLITTERS; k++) share[g - 2][i][k] = 100*(g == 2 ? r->purity[k] : r->recovery[k]);
            study_curve(&f[g], kept[i].name, STUDY_LINE, SPLITTERS, place, share[g - 2][i]);
        }
        snprintf(title, sizeof title, "%s: %s", w->title, names[g]);
        f[g].title = title;
        snprintf(file, sizeof file, "%s_%s.svg", w->name, names[g]);
        study_figure_write(&f[g], file);
    }
}
static void sweep_table_write(const sweep *w, const double *value, int count) {
    enum { COLUMNS = 16 };
    double column[COLUMNS][VALUES];
    const double *columns[COLUMNS];
    char file[64];
    int i, g;
    for (i = 0; i < count; i++) {
        column[0][i] = value[i];
        for (g = 0; g < 2; g++) {
            column[1 + 4*g][i] = kept[i].x[g].mean; column[2 + 4*g][i] = kept[i].x[g].error;
            column[3 + 4*g][i] = kept[i].sd[g].mean; column[4 + 4*g][i] = kept[i].sd[g].error;
        }
        column[9][i] = kept[i].quality.mean; column[10][i] = kept[i].quality.error;
        column[11][i] = kept[i].x[2].mean; column[12][i] = kept[i].x[2].error;
        column[13][i] = kept[i].sd[2].mean; column[14][i] = kept[i].sd[2].error;
        column[15][i] = kept[i].compute.mean;
    }
    for (i = 0; i < COLUMNS; i++) columns[i] = column[i];
    snprintf(file, sizeof file, "%s.csv", w->name);
    study_csv(file, "value,metal_x,error,metal_sd,error,plastic_x,error,plastic_sd,error,quality,error,"
              "middling_x,error,middling_sd,error,compute", count,
              COLUMNS, columns);
}
static void sweep_run(const sweep *w, const struct separator_options *base) {
    double asked[VALUES], value[VALUES];
    int i, count = 0, cases;
    memcpy(asked, w->value, sizeof asked);
    cases = study_values_take(base->values, w->words[0] != 0, asked, w->count, VALUES);
    for (i = 0; i < cases; i++) {
        struct separator_options o = *base;
        w->set(&o, asked[i]);
        if (!study_within(table, OPTIONS, &options, &o)) return;
    }
    for (i = 0; i < cases; i++) {
        struct separator_options o = *base;
        char name[32];
        w->set(&o, asked[i]);
        if (w->words[0]) snprintf(name, sizeof name, "%s", w->words[(int)asked[i]]);
        else snprintf(name, sizeof name, "%s%g", w->name, asked[i]);
        value[count] = asked[i];
        if (!value_run(&o, name, &kept[count])) count++;
    }
    if (count > 1) sweep_means_draw(w, value, count);
    if (count) sweep_curves_draw(w, base, count);
    if (count) sweep_table_write(w, value, count);
}

/* ---- equal bits ---- */

static uint64_t bits_run(separator *s, const struct separator_options *o, int threads, int from, int steps) {
    const char *path = study_path("check.dem");
    separator_desc d;
    dem_result result = DEM_OK;
    uint64_t hash = 0;
    int i;
    if (!desc_of(&d, o)) return 0;
    d.threads = threads;
    if (separator_create(s, &d) != DEM_OK) { study_fail("%s", s->error); return 0; }
    if (from) {
        result = dem_checkpoint_read(s->world, path);
        if (result == DEM_OK) result = separator_restored(s);
        if (result != DEM_OK) study_fail("%s", dem_world_error_get(s->world));
    }
    for (i = from; i < steps && result == DEM_OK; i++) {      /* of a millisecond */
        result = separator_step(s);
        if (result != DEM_OK) study_fail("%s", s->error);
        if (i + 1 == steps/2 && !from && dem_checkpoint_write(s->world, path) != DEM_OK)
            study_fail("%s", dem_world_error_get(s->world));
    }
    hash = dem_world_hash_get(s->world);
    if (s->unbalanced) study_fail("%.0f steps at which a class was not in balance", (double)s->unbalanced);
    return hash;
}
/* Runs a slice of spheres and some middlings that is wide enough for several threads (more than 2048 grains). */
static void check_run(const struct separator_options *base) {
    static const int threads[5] = {1, 2, 3, 4, 8};
    static separator s;
    struct separator_options o = *base;
    uint64_t first = 0, hash;
    const int steps = options.brief ? 100 : 400;
    int i;
    char name[32], text[32];
    o.rate = 10000;
    o.width = 0.2;
    o.middling = 0.1;
    for (i = 0; i < 6; i++) {
        hash = i < 5 ? bits_run(&s, &o, threads[i], 0, steps) : bits_run(&s, &o, 2, steps/2, steps);
        if (i < 5) snprintf(name, sizeof name, "hash.threads%d", threads[i]);
        else snprintf(name, sizeof name, "hash.restarted");
        snprintf(text, sizeof text, "%08lx%08lx", (unsigned long)(hash >> 32), (unsigned long)(hash & 0xffffffffu));
        study_result_text(name, text, "");
        if (i == 0) {
            first = hash;
            study_result("grains", dem_bodies_get(s.world).count, "");
            study_result("domains", dem_counters_get(s.world).domains, "");
        } else if (hash != first) study_fail("%s: other bits than with one thread", name);
        separator_end(&s);
    }
}

/* ---- what a step costs ---- */

typedef struct cost { double step, sweeps, residual, overlap; int unsolved, steps, threads; } cost;

/* Continues the saved stream with the contacts of the options: for a millisecond, then for `span` (s), whose steps are timed.
   Returns 0 on success. */
static int cost_measure(const struct separator_options *o, const char *state, double span, cost *c) {
    static separator s;
    separator_desc d;
    dem_result result;
    double begun = 0, from = 0;
    int bad = 1;
    memset(c, 0, sizeof *c);
    if (!desc_of(&d, o)) return 1;
    result = separator_create(&s, &d);
    if (result == DEM_OK) {
        result = separator_refused(&s, dem_checkpoint_read_changed(s.world, state, "dt sweeps tolerance cold_start cone solver"));
        if (result == DEM_OK) result = separator_restored(&s);
    }
    while (result == DEM_OK && !(from > 0 && dem_world_time_get(s.world) > from + span)) {
        result = separator_step(&s);
        if (from > 0) continue;
        from = dem_world_time_get(s.world);
        c->unsolved = -(int)dem_counters_get(s.world).unsolved;
        s.sweeps = s.residual_max = 0;
        s.steps = 0;
        dem_overlap_max_reset(s.world);
        begun = study_clock();
    }
    if (result == DEM_OK) {
        const dem_counters k = dem_counters_get(s.world);
        c->steps = (int)s.steps;
        c->step = 1000*(study_clock() - begun)/c->steps;
        c->sweeps = s.sweeps/c->steps;
        c->residual = s.residual_max;
        c->overlap = (double)k.overlap_max;
        c->unsolved += (int)k.unsolved;
        c->threads = k.threads;
        bad = 0;
    } else study_fail("%s", s.error);
    separator_end(&s);
    return bad;
}
/* few, many: the same with 20 and 60 sweeps in each solve. The papers take 100 in each, so their share of the time follows from
   the difference. Ours ends its sweeps at a tolerance, and solves a step again when the feed has added a grain; then the number
   of all sweeps is not known. A thin stream needs fewer sweeps than 60. */
static void cost_tell(const char *name, const cost *c, const cost *few, const cost *many, int papers) {
    const double more = many->sweeps - few->sweeps;
    snprintf(study.prefix, sizeof study.prefix, "%s.", name);
    study_result("steps", c->steps, "");
    if (!papers) study_result("unsolved", c->unsolved, "solves");        /* the papers take all their sweeps */
    study_result("sweeps_mean", c->sweeps, "");
    study_result("residual_max", c->residual, "m/s");
    study_result("overlap_max", c->overlap, "");
    study_result("step", c->step, "ms");
    if (papers && more > 1) study_result("sweeps_share", 100*c->sweeps*(many->step - few->step)/more/c->step, "%");
    study.prefix[0] = 0;
}
/* Runs the stream until --seconds and saves it. Continues from there in three ways: with our setting, with that of the papers,
   and with that of the papers and the spectral solver; each on one thread and on all. */
static void load_run(struct separator_options *base) {
    static const char *const names[3] = {"ours", "papers_seidel", "papers_spectral"};
    static separator s;
    static outcome r;
    const double span = base->brief ? 2e-3 : 0.02;
    char state[1024];
    int way, all, bad;
    snprintf(state, sizeof state, "%s", *base->resume ? base->resume : study_path("load.dem"));
    base->drain = -1;                          /* the feed lasts longer than the run */
    base->seconds += 1;
    bad = *base->resume ? 0 : separator_run(&s, base, "load", &r, 0);
    if (!bad && !*base->resume) {
        study_result("grains", dem_bodies_get(s.world).count, "");
        study_result("candidates", dem_counters_get(s.world).candidates, "pairs");
        study_result("unknowns_max", 3.0*s.loaded_max, "components of impulses, in the step with most of them");
        outcome_tell(&r, 0);
        if (dem_checkpoint_write(s.world, state) != DEM_OK) study_fail("%s", dem_world_error_get(s.world));
    }
    separator_end(&s);
    for (way = 0; way < 3 && !bad; way++)
        for (all = 0; all < 2; all++) {
            struct separator_options o = *base;
            cost whole, few, many;
            char name[48];
            o.setting = way ? "seeds" : "ours";
            o.solver = way == 2 ? "spectral" : "seidel";
            o.threads = all ? 0 : 1;
            if (cost_measure(&o, state, span, &whole)) return;
            if (all && whole.threads == 1) continue;
            o.tolerance = 1e-30;
            o.sweeps = 20;
            if (cost_measure(&o, state, span/2, &few)) return;
            o.sweeps = 60;
            if (cost_measure(&o, state, span/2, &many)) return;
            snprintf(name, sizeof name, "%s.threads%d", names[way], whole.threads);
            cost_tell(name, &whole, &few, &many, way);
        }
}

static void one_run(const struct separator_options *o) {
    static separator s;
    static outcome r;
    FILE *report;
    if (!separator_run(&s, o, "separator", &r, "grains.svg")) {
        outcome_tell(&r, 1);
        distribution_draw(&r);
        splitter_draw(o, &r);
        if (r.mass[SEPARATOR_MIDDLING] > 0) products_draw(o, &r, "");
        tables_write(o, &r);
        report = study_open("report.txt");
        if (report) { dem_world_report(s.world, report); study_close(report, "report.txt"); }
    }
    separator_end(&s);
}

int main(int argc, char **argv) {
    size_t i;
    study_options(argc, argv, "A corona electrostatic separator after Critelli, Tasora and others (2014).", table,
        OPTIONS);
    if (options.quick) {                       /* options given by name keep their values */
        options.seconds = 1.5;
        options.drain = 1;
        study_options(argc, argv, "", table, OPTIONS);
    }
    if (options.brief) {
        options.repeats = 1;
        options.seconds = 0.05;
        options.drain = 0.45;                  /* in which grains land; not by springs */
    }
    if (options.check) options.study = "check";
    study_begin(options.out);
    if (is(options.study, "run") || is(options.study, "check") || is(options.study, "load"))
        study_values_unused(options.values, "this study");
    if (is(options.study, "run")) one_run(&options);
    else if (is(options.study, "check")) check_run(&options);
    else if (is(options.study, "load")) load_run(&options);
    else
        for (i = 0; i < sizeof sweeps/sizeof *sweeps; i++)
            if (is(sweeps[i].name, options.study)) sweep_run(&sweeps[i], &options);
    return study_end();
}
