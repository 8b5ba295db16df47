/* mill.c - a tumbling mill: glass beads in a rotating drum with lifters.

   The machine is that of [MIL], a thesis on tumbling mills on a GPU: a drum of 300 mm with glass
   beads of 3 mm (its Fig 5.24). The default run differs from the thesis so that it ends soon:
     - It simulates a thin slice, periodic along the axis, with as many beads per length as in the
       thesis, which has 303156 in 270 mm. These are 7635 beads, a charge of 37.4 % of the volume.
     - Beads are softer. --soften F lowers every Young's modulus that exceeds that of glass over F
       to this value; --stiffness true simulates the glass of the thesis.
     - The mill settles for half a revolution and is measured for half a revolution. In the thesis
       it was three, and one or more.
   --first is the run of `make run`: beads of 6 mm in a slice that is twice as thick, so that there are a
   quarter as many, with steps twice as long. Its replay begins after settling, when the charge flows.
   The thesis shows its lifters only as a picture of 259 points and 259 lines. Our
   examples/data/mill_300mm.profile has the same numbers of both, with 12 trapezoidal lifters that
   we chose: 9 mm high, 16 mm wide at the foot, 8 mm at the top (made by --write-profile).

   build:  cc -O2 -std=c99 -fopenmp examples/mill.c dem.c -o build/mill -lm    (-fopenmp is optional)
   run:    build/mill, build/mill --first, build/mill --quick, build/mill --help
           over MPI: examples/mpi/mill.c

   The axis is z, gravity points to -y, and the mill rotates about +z: seen with x to the right it
   rotates anticlockwise and carries the charge up on the right. The critical speed is that of the
   thesis, 42.3/sqrt(D) revolutions per minute. Results, measured over the last --revolutions:
     rate                 grains times steps per second of wall time
     solidicity_bulk      mean solid fraction of the cells (64 x 64) in which it is above 0.4
     shell_speed_ratio    speed of the grains whose centre is within 1.5 diameters of the shell,
                          from 20 degrees after the toe to 20 before the shoulder, over omega
                          times the radius of the shell
     overlap_max          largest overlap of the whole run, over the radius
     torque_mean          N m, of the mill on the charge of the slice
     torque_balance_error |T - M g x|/(M g x), x: mean horizontal offset of the charge's centre
     momentum_balance_error  the same, less the growth of the charge's angular momentum: an
                          identity that is exact except for the sampling of x
     power_balance_error  |T omega - D|/(T omega), D: rate of dissipation and of growth of the
                          energy stored, elevation included. The ledger sums the dissipation
                          contact by contact
     ledger_residual      energy that the ledger cannot account for, over the energy put through,
                          of the whole run; falls with the third power of the step
     toe, shoulder        the two angles at which the solid fraction falls below half of the bulk's,
                          on a ring at 0.84 to 0.92 of the shell's radius (inside the lifters). In
                          degrees from straight down, positive in the direction of rotation
     splash               share of the charge in dilute flow at the toe (map_splash)
     bend                 amplitude of the S of the free surface, over its length from toe to shoulder (map_bend)
     steady_after         revolutions after which the torque, averaged over half a turn, stays
                          within 5 % of its mean
     grains_missing       grains inserted less grains present, plus grains outside the shell
     hash                 of the final state: the same for any number of threads
   --spectrum also records every contact that ends while the mill is measured:
     contact_rate         contacts that end per second, in the slice
     event_balance_error  |E - D|/D, E: energy lost in all contacts, D: that of the ledger
     wear_on_lifters      part of the work of sliding on the shell that is done on the lifters
     files: spectrum.svg (rates over the energy of impact), losses.svg (power over the energy lost in
     a contact), impacts.csv (both, for each pair of materials)
   --replay: a replay of the run, from --replay-from on. Files: solidicity and velocity at 64, 128 and 256
   cells, torque, power, grains (SVG); torque.csv, ledger.csv; frames for ParaView (VTP); report.txt; summary.txt. */
#include "../dem.h"
#include "drum.h"
#include "study.h"
#include "study_replay.h"

#define PI 3.14159265358979323846
#define GRAVITY 9.81
#define CELLS 256          /* of the finest map; the others are sums of its cells */
#define REPLAY_FRAMES 120
#define REPEATS 20         /* at most */
#define SAMPLES 240        /* of torque and energy, per revolution */

static struct mill_options {
    double diameter, length, radius, speed, fill, friction, wall_friction, soften, dt;
    double contact_steps, revolutions, settle, replay_from, aspect;
    const char *grains, *ends, *profile, *wall, *stiffness, *law, *response, *integrator, *tangent, *study, *values;
    const char *out;
    const char *checkpoint, *resume, *write_profile;
    int seed, repeats, threads, slabs, frames, first, quick, brief, replay, spectrum;
} options = {0.3, 0.0068, 0.0015, 0.7, 0.37426, 0.154, 0.32, 500, 0, 20, 0.5, 0.5, 0, 1.5,
             "sphere", "periodic", "lifters", "mesh", "soft", "hertz", "springs", "verlet", "auto", "mill", "",
             "build/out/mill", 0, 0, 0, 1, 0, 0, 0, 4, 0, 0, 0, 0, 0};

/* in the order of dem_integrator and dem_tangent_law */
#define INTEGRATORS "verlet|euler|symplectic|position|leapfrog"
#define TANGENTS "auto|none|viscous|step|spring|mindlin|rescaled"
static const study_option table[] = {
    {"diameter", STUDY_REAL, &options.diameter, 0.02, 20, "m",
        "of the drum; lifters scale with it"},
    {"length", STUDY_REAL, &options.length, 0.003, 20, "m", "of the slice simulated"},
    {"ends", STUDY_CHOICE, &options.ends, 0, 0, "periodic|flat", "of the slice"},
    {"radius", STUDY_REAL, &options.radius, 1e-4, 0.5, "m", "of the beads"},
    {"grains", STUDY_CHOICE, &options.grains, 0, 0, "sphere|pair|rod|tetra",
        "shape: 1, 2, 3 or 4 spheres, of the volume of the bead"},
    {"aspect", STUDY_REAL, &options.aspect, 1, 3, "", "length over width of a pair (at most 1.9) or rod"},
    {"seed", STUDY_INT, &options.seed, 1, 1000000, "", "of the places at the start"},
    {"repeats", STUDY_INT, &options.repeats, 0, REPEATS, "",
        "runs of each case, with consecutive seeds (sheet: drops); 0: 3, or 1 for speeds and friction"},
    {"speed", STUDY_REAL, &options.speed, 0.05, 3, "of critical", "of the mill"},
    {"fill", STUDY_REAL, &options.fill, 0.01, 0.9, "of the volume",
        "charge, at a solid fraction of 0.6"},
    {"profile", STUDY_TEXT, &options.profile, 0, 0, "",
        "lifters (of examples/data), none (smooth), or a file"},
    {"wall", STUDY_CHOICE, &options.wall, 0, 0, "mesh|grains",
        "grains: a smooth drum lined with beads"},
    {"friction", STUDY_REAL, &options.friction, 0, 5, "", "between beads"},
    {"wall-friction", STUDY_REAL, &options.wall_friction, 0, 5, "", "between beads and mill"},
    {"stiffness", STUDY_CHOICE, &options.stiffness, 0, 0, "true|soft", "of beads and mill"},
    {"soften", STUDY_REAL, &options.soften, 1, 1e6, "",
        "soft: nothing is stiffer than glass over this"},
    {"dt", STUDY_REAL, &options.dt, 0, 1, "s", "time step; 0: from --contact-steps"},
    {"contact-steps", STUDY_REAL, &options.contact_steps, 20, 1e6, "",
        "steps in the shortest contact at shell speed"},
    {"law", STUDY_CHOICE, &options.law, 0, 0, "hertz|linear", "normal force"},
    {"response", STUDY_CHOICE, &options.response, 0, 0, "springs|impulses",
        "of contacts; impulses: rigid beads, steps of 2e-4 s unless --dt says otherwise"},
    {"integrator", STUDY_CHOICE, &options.integrator, 0, 0, INTEGRATORS, "scheme"},
    {"tangent", STUDY_CHOICE, &options.tangent, 0, 0, TANGENTS, "friction law"},
    {"revolutions", STUDY_REAL, &options.revolutions, 0.05, 1000, "", "measured"},
    {"settle", STUDY_REAL, &options.settle, 0, 1000, "", "revolutions before that"},
    {"threads", STUDY_INT, &options.threads, 0, 64, "", "0: as many as there are"},
    {"slabs", STUDY_INT, &options.slabs, 0, 1024, "",
        "the drum dealt across x to as many slabs; 0: one world"},
    {"out", STUDY_TEXT, &options.out, 0, 0, "", "folder for results"},
    {"first", STUDY_FLAG, &options.first, 0, 0, "", "coarser beads; the replay begins after settling"},
    {"quick", STUDY_FLAG, &options.quick, 0, 0, "", "a smaller mill, under 20 s on two cores"},
    {"short", STUDY_FLAG, &options.brief, 0, 0, "", STUDY_SHORT},
    {"replay", STUDY_FLAG, &options.replay, 0, 0, "", "write replay.html, which a browser plays"},
    {"replay-from", STUDY_REAL, &options.replay_from, 0, 1000, "", "revolutions before its first frame"},
    {"spectrum", STUDY_FLAG, &options.spectrum, 0, 0, "",
        "record contacts while measuring: impact energies, collision rates, wear"},
    {"frames", STUDY_INT, &options.frames, 0, 100000, "",
        "VTP files of grains and mill over the run"},
    {"checkpoint", STUDY_TEXT, &options.checkpoint, 0, 0, "",
        "file written every quarter revolution"},
    {"resume", STUDY_TEXT, &options.resume, 0, 0, "",
        "such a file, of a run with the same options"},
    {"study", STUDY_CHOICE, &options.study, 0, 0, "mill|drop|rebound|sheet|overlap|speeds|friction|control|fields|backup",
        "what to run"},
    {"values", STUDY_TEXT, &options.values, 0, 0, "", "values for --study speeds or friction, such as 0.5,0.6"},
    {"write-profile", STUDY_TEXT, &options.write_profile, 0, 0, "",
        "write the lifters' profile to a file, and stop"},
};
enum { OPTIONS = sizeof table/sizeof *table };
/* Runs of each case. */
static int runs_of(int usual) { return options.repeats ? options.repeats : usual; }

typedef struct sample {    /* sums since the start, so that any window is a difference */
    double time, impulse, work, x, angular; /* s, N m s, J, m, kg m2/s */
    dem_ledger ledger;
} sample;

typedef struct mill {
    struct mill_options o;
    dem_world *world;
    dem_material glass, lining;
    dem_wall walls[3];
    dem_profile profile;
    dem_field field;
    int wall_count, grains, sample_count, sample_steps, settled;
    int cells;             /* of the field along x and y; 0: CELLS, below 0: no field */
    int recorded;          /* 1: contacts are recorded */
    double shell, critical, omega, period, dt, mass;
    sample *samples;
    double torque, power, toe, shoulder, solidicity, bend;
    dem_shape shape;       /* null: spheres */
    double bound, scale;   /* bounding radius over that of the bead; lengths of the bead over those of the shape */
} mill;

static const char *program_path; /* argv[0]: the data lie relative to it */
/* the rank of this process, the number of processes, and their transport: set by examples/mpi/mill.c */
static int mill_rank, mill_ranks = 1;
static dem_transport mill_transport;

static int is(const char *a, const char *b) { return !strcmp(a, b); }

static int place_of(const char *word, const char *list) { /* index of a word in "one|another", which contains it */
    int place = 0;
    const char *at = strstr(list, word);
    while (at > list) place += *--at == '|';
    return place;
}

static int refused(dem_world *world, dem_result result) {
    if (result != DEM_OK) study_fail("%s", dem_world_error_get(world));
    return result != DEM_OK;
}

static int world_create(mill *m, const dem_world_desc *desc) {
    m->world = dem_world_create(desc);
    if (!m->world) study_fail("%s", dem_world_create_error_get(desc));
    return !m->world;
}

static void mill_destroy(mill *m) {
    if (m->profile.vertices) dem_profile_free(m->world, &m->profile);
    dem_world_destroy(m->world);
    memset(&m->profile, 0, sizeof m->profile);
    m->world = 0;
}

/* Materials of Fig 5.24 of [MIL]. Its coefficients for beads against the mill ("ps") are set for the
   pair, with moduli mixed by Hertz. A lining of beads is of glass, as in its section 5.2.1, with the
   coefficients of bead on bead. */
static int materials_add(mill *m) {
    static const double density[2] = {2500, 950}, poisson[2] = {0.23, 0.42};
    static const double shear[2] = {26e9, 0.31e9};
    double limit = is(m->o.stiffness, "soft") ? 2*shear[0]*(1 + poisson[0])/m->o.soften : 1e300;
    dem_material made[2];
    dem_pair pair;
    int i;
    for (i = 0; i < 2; i++) {
        dem_material_desc d = DEM_MATERIAL_DESC;
        d.density = density[i];
        d.young = fmin(2*shear[i]*(1 + poisson[i]), limit);
        d.poisson = poisson[i];
        d.restitution = i ? 0.55 : 0.66;
        d.friction = i ? m->o.wall_friction : m->o.friction;
        made[i] = dem_material_add(m->world, &d);
        if (!made[i].id) return refused(m->world, DEM_ERROR_ARGUMENT);
    }
    m->glass = made[0];
    m->lining = made[is(m->o.wall, "mesh")];
    if (refused(m->world, dem_pair_get(m->world, made[0], made[1], &pair))) return 1;
    pair.restitution = 0.55;
    pair.friction = pair.friction_static = m->o.wall_friction;
    return refused(m->world, dem_pair_set(m->world, made[0], made[1], &pair));
}

/* ---- the shell ---- */

/* 12 lifters on a circle of 300 mm: 48 corners and 211 points on the arcs between them, 259 as in
   [MIL]. */
static int profile_write(const char *path) {
    static const double corner[4][2] = {{0, -0.008}, {0.141, -0.004}, {0.141, 0.004}, {0, 0.008}};
    FILE *file = fopen(path, "wb");
    double foot = asin(0.008/0.15), span = PI/6 - 2*foot;
    int lifter, i;
    if (!file) { study_fail("cannot write %s: %s", path, strerror(errno)); return 1; }
    fprintf(file, "259 259\n");
    for (lifter = 0; lifter < 12; lifter++) {
        double a = lifter*PI/6;
        int points = (lifter + 1)*211/12 - lifter*211/12;
        for (i = 0; i < 4; i++) {
            double x = corner[i][0] > 0 ? corner[i][0] : 0.15*cos(foot), y = corner[i][1];
            fprintf(file, "%.9g %.9g\n", x*cos(a) - y*sin(a), x*sin(a) + y*cos(a));
        }
        for (i = 1; i <= points; i++) {
            double on = a + foot + span*i/(points + 1);
            fprintf(file, "%.9g %.9g\n", 0.15*cos(on), 0.15*sin(on));
        }
    }
    for (i = 1; i <= 259; i++) fprintf(file, "%d %d\n", i, i%259 + 1);
    if (fclose(file)) { study_fail("%s was not written in full", path); return 1; }
    return 0;
}

/* Reads our profile, from the present folder or from beside the program's folder, and scales it to the
   drum. */
static int profile_load(mill *m) {
    static const char *const place = "examples/data/mill_300mm.profile";
    char path[1024];
    const char *slash = strrchr(program_path, '/');
    int i, ours = is(m->o.profile, "lifters");
    FILE *file = fopen(place, "rb");
    if (file) fclose(file);
    if (!ours) snprintf(path, sizeof path, "%s", m->o.profile);
    else if (file || !slash) snprintf(path, sizeof path, "%s", place);
    else snprintf(path, sizeof path, "%.*s/../%s", (int)(slash - program_path), program_path,
                  place);
    if (refused(m->world, dem_profile_read(m->world, path, &m->profile))) return 1;
    for (i = 0; ours && i < 2*m->profile.vertex_count; i++)
        m->profile.vertices[i] *= m->o.diameter/0.3;
    return 0;
}

/* Returns 1 if a disc at (x, y) is inside the shell and does not touch it. Its centre is inside if a
   ray to the right crosses the profile an odd number of times. */
static int has_room(const mill *m, double x, double y, double radius) {
    const dem_profile *p = &m->profile;
    int i, inside = 0;
    if (hypot(x, y) + radius > m->shell) return 0;
    if (!p->segment_count || hypot(x, y) < 0.7*m->shell) return 1;
    for (i = 0; i < p->segment_count; i++) {
        const dem_real *a = p->vertices + 2*p->segments[2*i];
        const dem_real *b = p->vertices + 2*p->segments[2*i + 1];
        double dx = b[0] - a[0], dy = b[1] - a[1];
        double t = fmin(fmax(((x - a[0])*dx + (y - a[1])*dy)/(dx*dx + dy*dy), 0), 1);
        if (hypot(x - a[0] - t*dx, y - a[1] - t*dy) < radius) return 0;
        if ((a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1])*dx/dy) inside = !inside;
    }
    return inside;
}

static int shell_add(mill *m) {
    dem_motion turning = DEM_MOTION;
    double R = m->o.diameter/2, r = m->o.radius, L = m->o.length;
    dem_vec3 centre = dem_vec3_make(0, 0, 0), axis = dem_vec3_make(0, 0, 1);
    int i, count;
    m->wall_count = 1;
    if (is(m->o.wall, "grains")) {
        /* grains of a wall are not seen across a periodic end, so the lining goes on beyond it: its
           layers are r sqrt(3) apart, and mill_begin made the slice an even number of them */
        double lining = is(m->o.ends, "flat") ? L : L + 12*r;
        dem_real *at;
        count = drum_grains(R, lining, r, 0, 0);
        at = (dem_real *)study_alloc(3*(size_t)count, sizeof *at);
        drum_grains(R, lining, r, 0, at);
        m->walls[0] = dem_wall_grains_add(m->world, m->lining, count, at, r, 1);
        free(at);
    } else if (is(m->o.profile, "none")) {
        m->walls[0] = dem_wall_cylinder_add(m->world, m->lining, centre, axis, R, 1);
    } else {
        if (profile_load(m)) return 1;
        m->walls[0] = dem_wall_profile_add(m->world, m->lining, &m->profile, DEM_EDGE_RESOLVED);
    }
    for (i = -1; i <= 1 && is(m->o.ends, "flat"); i += 2) {
        centre.z = i*L/2;
        m->walls[m->wall_count++] = dem_wall_plane_add(m->world, m->lining, centre,
                                                  dem_vec3_make(0, 0, -i));
    }
    turning.kind = DEM_MOTION_ROTATING;
    turning.axis = axis;
    turning.speed = m->omega;
    for (i = 0; i < m->wall_count; i++) {
        if (!m->walls[i].id) return refused(m->world, DEM_ERROR_ARGUMENT);
        if (refused(m->world, dem_wall_motion_set(m->world, m->walls[i], &turning))) return 1;
    }
    return 0;
}

/* ---- the charge ---- */

static int is_site(dem_vec3 c, dem_real radius, void *user) {
    const mill *m = (const mill *)user;
    return fabs(c.z) + 1.02*radius <= m->o.length/2 && has_room(m, c.x, c.y, 1.02*radius);
}
/* Sorts places by depth below a surface that rises by 30 degrees to the right. */
static int site_lower(const void *a, const void *b) {
    const dem_real *p = (const dem_real *)a, *q = (const dem_real *)b;
    double high = (p[1] - q[1])*cos(PI/6) - (p[0] - q[0])*sin(PI/6);
    return high < 0 ? -1 : high > 0 ? 1 : p[2] < q[2] ? -1 : p[2] > q[2];
}

/* Adds the shape of the grains, a cluster. */
static int shape_add(mill *m) {
    const dem_real a = m->o.aspect - 1, t = 0.5;
    const dem_real row[9] = {a, 0, 0, -a, 0, 0, 0, 0, 0}, tetra[12] = {t, t, t, t, -t, -t, -t, t, -t, -t, -t, t};
    dem_cluster_desc d = DEM_CLUSTER_DESC;
    dem_shape_info info;
    double equal;
    m->bound = 1;
    m->shape.id = 0;
    if (is(m->o.grains, "sphere")) return 0;
    d.count = is(m->o.grains, "pair") ? 2 : is(m->o.grains, "rod") ? 3 : 4;
    d.positions = d.count == 4 ? tetra : row;
    d.radius = 1;
    m->shape = dem_shape_cluster_add(m->world, &d);
    if (!m->shape.id || dem_shape_get(m->world, m->shape, &info) != DEM_OK) return refused(m->world, DEM_ERROR_ARGUMENT);
    equal = cbrt(3*info.volume/(4*PI));
    m->bound = info.radius/equal;
    m->scale = m->o.radius/equal;
    return 0;
}
static double chance(uint32_t *random) {
    *random = *random*1664525u + 1013904223u;
    return (*random >> 8)/16777216.0;
}

/* Packs the mill hexagonally, with some padding, in a separate world. The lowest places get a grain
   that rotates with the mill. Each grain is moved at random within the padding; otherwise rows would
   remain rows for long. */
static int charge_add(mill *m) {
    double R = m->o.diameter/2, L = m->o.length, r = m->o.radius, padding = 0.05*r;
    const double wide = m->bound*r;
    dem_box box = dem_box_make(-R, -R, -L/2 + padding/2, R, R, L/2 - padding/2);
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_bodies sites;
    dem_real *at, *velocity, *turned, *scales;
    uint32_t random = (uint32_t)m->o.seed;
    int i, bad;
    mill packed = *m;
    if (world_create(&packed, &desc) || materials_add(&packed)) return 1;
    dem_spheres_pack(packed.world, packed.glass, wide, padding, dem_region_inside_make(box, is_site, m),
                     0);
    sites = dem_bodies_get(packed.world);
    at = (dem_real *)study_alloc(3*(size_t)sites.count, sizeof *at);
    velocity = (dem_real *)study_alloc(3*(size_t)sites.count, sizeof *velocity);
    turned = (dem_real *)study_alloc(4*(size_t)sites.count, sizeof *turned);
    scales = (dem_real *)study_alloc((size_t)sites.count, sizeof *scales);
    for (i = 0; i < 3*sites.count; i++) at[i] = sites.positions[i/3*4 + i%3];
    qsort(at, (size_t)sites.count, 3*sizeof *at, site_lower);
    m->grains = (int)(m->o.fill*0.6*PI*m->shell*m->shell*L/(4*PI*r*r*r/3) + 0.5);
    bad = m->grains > sites.count;
    if (bad) study_fail("--fill %g asks for %d grains, but only %d fit into the mill", m->o.fill,
                        m->grains, sites.count);
    for (i = 0; i < 3*sites.count; i++) {
        at[i] += 0.4*padding*(chance(&random) - 0.5);
        velocity[i] = i%3 == 0 ? -m->omega*at[i + 1] : i%3 == 1 ? m->omega*at[i - 1] : 0;
    }
    for (i = 0; m->shape.id && i < sites.count; i++) {     /* random orientations, as the signs of four numbers mix */
        int k;
        for (k = 0; k < 4; k++) turned[4*i + k] = chance(&random) + chance(&random) + chance(&random) - 1.5;
        turned[4*i] += 1e-6;
        scales[i] = m->scale;
    }
    if (!bad && m->shape.id)
        bad = refused(m->world, dem_bodies_add(m->world, m->glass, m->shape, m->grains, at, turned, velocity, 0, scales));
    else if (!bad)
        bad = refused(m->world, dem_spheres_add(m->world, m->glass, m->grains, at, velocity, 0, r));
    free(at);
    free(velocity);
    free(turned);
    free(scales);
    dem_world_destroy(packed.world);
    return bad;
}

/* ---- the mill ---- */

static int mill_create(mill *m, double dt) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_field_desc field;
    double R = m->o.diameter/2, L = m->o.length;
    desc.gravity.y = -GRAVITY;
    desc.normal_law = is(m->o.law, "linear") ? DEM_NORMAL_LINEAR : DEM_NORMAL_HERTZ;
    desc.integrator = (dem_integrator)place_of(m->o.integrator, INTEGRATORS);
    desc.tangent_law = (dem_tangent_law)place_of(m->o.tangent, TANGENTS);
    desc.impact_speed = m->omega*R;
    if (is(m->o.response, "impulses")) desc.response = DEM_RESPONSE_IMPULSES;
    desc.threads = m->o.threads;
    desc.ledger = 1;
    desc.dt = dt;
    if (is(m->o.ends, "periodic")) {
        desc.domain = dem_box_make(-1.1*R, -1.1*R, -L/2, 1.1*R, 1.1*R, L/2);
        desc.boundary[2] = DEM_BOUNDARY_PERIODIC;
    }
    if (world_create(m, &desc) || materials_add(m) || shell_add(m) || shape_add(m) || charge_add(m)) return 1;
    memset(&field, 0, sizeof field);
    field.box = dem_box_make(-R, -R, -L/2, R, R, L/2);
    field.cells[0] = field.cells[1] = m->cells ? m->cells : CELLS;
    field.cells[2] = 1;
    field.start = m->settled*m->period/SAMPLES;
    field.interval = m->period/720;
    if (m->cells < 0) return 0;
    m->field = dem_field_add(m->world, &field);
    return m->field.id ? 0 : refused(m->world, DEM_ERROR_ARGUMENT);
}

/* Chooses the time step so that samples fall on whole steps. The scene is built twice: the first one
   gives the advised step. */
static int mill_begin(mill *m) {
    dem_advice advice;
    double wanted = m->o.dt, pair = 2*sqrt(3.0)*m->o.radius;
    m->shell = m->o.diameter/2;
    if (is(m->o.wall, "grains")) { /* no lifters; layers of the lining meet across a periodic end */
        m->shell -= 2*m->o.radius;
        m->o.profile = "none";
        if (is(m->o.ends, "periodic"))
            m->o.length = pair*fmax(2, floor(m->o.length/pair + 0.5));
    }
    m->critical = 42.3/sqrt(m->o.diameter)*2*PI/60;
    m->omega = m->o.speed*m->critical;
    m->period = 2*PI/m->omega;
    m->settled = (int)(m->o.settle*SAMPLES + 0.5);
    if (!(wanted > 0) && is(m->o.response, "impulses")) wanted = 2e-4;
    if (!(wanted > 0)) {
        int bad = mill_create(m, 0) || refused(m->world, dem_step_advice_get(m->world, &advice));
        mill_destroy(m);
        if (bad) return 1;
        wanted = advice.contact_time/m->o.contact_steps;
    }
    m->sample_steps = (int)ceil(m->period/SAMPLES/wanted);
    m->dt = m->o.dt > 0 ? m->o.dt : m->period/SAMPLES/m->sample_steps;
    if (mill_create(m, m->dt)) return 1;
    dem_world_check_print(m->world, mill_rank ? 0 : stderr);             /* every process checks, so that all stay alike */
    m->mass = dem_totals_get(m->world).mass;
    return 0;
}

static void sample_take(const mill *m, sample *s) {
    dem_totals totals = dem_totals_get(m->world);
    int i;
    memset(s, 0, sizeof *s);
    s->time = dem_world_time_get(m->world);
    s->ledger = dem_ledger_get(m->world);
    s->x = totals.centre[0];
    s->angular = totals.angular[2];
    for (i = 0; i < m->wall_count; i++) {
        dem_wall_loads c;
        if (refused(m->world, dem_wall_loads_get(m->world, m->walls[i], &c))) return;
        s->impulse -= c.torque_impulse; /* of the mill on the grains */
        s->work += c.work;
    }
}

/* The samples so far are beside the checkpoint, in FILE.samples. */
static int samples_file(mill *m, const char *path, int writing, int *count) {
    char name[1024];
    FILE *file;
    size_t size = sizeof(sample);
    int good;
    snprintf(name, sizeof name, "%s.samples", path);
    file = fopen(name, writing ? "wb" : "rb");
    if (!file) { study_fail("cannot open %s: %s", name, strerror(errno)); return 1; }
    if (writing)
        good = fwrite(count, sizeof *count, 1, file) == 1 &&
               fwrite(m->samples, size, (size_t)*count, file) == (size_t)*count;
    else
        good = fread(count, sizeof *count, 1, file) == 1 && *count > 0 &&
               *count <= m->sample_count + 1 &&
               fread(m->samples, size, (size_t)*count, file) == (size_t)*count;
    if (fclose(file) || !good) { study_fail("%s is not whole, or of another run", name); return 1; }
    return 0;
}

static void frame_write(mill *m, int number) {
    char name[32];
    double z = m->o.length/2;
    if (study.quiet) return;
    snprintf(name, sizeof name, "grains_%04d.vtp", number);
    study.files += !refused(m->world, dem_vtp_write(m->world, study_path(name)));
    if (!m->profile.segment_count) return;
    snprintf(name, sizeof name, "mill_%04d.vtp", number);
    study.files += !refused(m->world, dem_walls_vtp_write(m->world, study_path(name), -z, z));
}

/* Distributes the drum to slabs and returns those of this process; null: there is one world only. */
static dem_slabs *slabs_begin(mill *m) {
    dem_slabs_desc desc = DEM_SLABS_DESC;
    dem_slabs *slabs;
    desc.count = m->o.slabs;
    desc.first = mill_rank*desc.count/mill_ranks;
    desc.local = (mill_rank + 1)*desc.count/mill_ranks - desc.first;
    desc.transport = mill_transport;
    slabs = desc.count ? dem_slabs_create(m->world, &desc) : 0;
    if (desc.count && !slabs) refused(m->world, DEM_ERROR_ARGUMENT);
    return slabs;
}
/* Runs to the next sample; then the world has the whole state. */
static int mill_step(mill *m, dem_slabs *slabs) {
    if (!slabs) return refused(m->world, dem_world_step(m->world, m->sample_steps));
    if (dem_slabs_step(slabs, m->sample_steps) == DEM_OK &&
        dem_slabs_collect(slabs, m->world) == DEM_OK) return 0;
    study_fail("%s", dem_slabs_error_get(slabs));
    return 1;
}
/* Writes a frame of the replay if one is due; torque and power are means since the last frame. */
static void mill_replay(const mill *m, study_replay *f, int k, int *since) {
    const sample *a = &m->samples[*since], *b = &m->samples[k];
    const double time = b->time - a->time;
    if (!study_replay_due(f)) return;
    if (time > 0) {
        study_replay_value(f, "torque (N m)", (b->impulse - a->impulse)/time);
        study_replay_value(f, "power (W)", (b->work - a->work)/time);
    }
    study_replay_value(f, "kinetic energy (J)", b->ledger.kinetic + b->ledger.rotational);
    study_replay_value(f, "ledger: residual (J)", b->ledger.residual);
    study_replay_frame(f);
    *since = k;
}
/* Records contacts from the first step on that is measured. */
static int spectrum_begin(mill *m, int k, int slabs) {
    if (!m->o.spectrum || k < m->settled || m->recorded) return 0;
    if (slabs) {
        study_fail("--spectrum with --slabs needs --settle 0: slabs record what their world records");
        return 1;
    }
    m->recorded = 1;
    return refused(m->world, dem_events_record(m->world, &DEM_EVENTS_DESC));
}
static int mill_turn(mill *m) { /* runs the mill */
    dem_slabs *slabs;
    study_replay f;
    int bad = 0;
    int k = 0, first, total, count, since = 0, opened, frames = m->o.frames;
    double begun, work = (double)m->grains*m->sample_steps;
    char what[64];
    m->sample_count = m->settled + (int)(m->o.revolutions*SAMPLES + 0.5);
    m->samples = (sample *)study_alloc((size_t)m->sample_count + 1, sizeof *m->samples);
    sample_take(m, &m->samples[0]);
    if (m->o.resume) {
        if (refused(m->world, dem_checkpoint_read(m->world, m->o.resume))) return 1;
        if (samples_file(m, m->o.resume, 0, &count)) return 1;
        k = count - 1;
    }
    if (spectrum_begin(m, k, 0)) return 1;
    slabs = slabs_begin(m);
    if (m->o.slabs && !slabs) return 1;
    total = m->sample_count;
    snprintf(what, sizeof what, "mill: %d grains, %.3g revolutions", m->grains,
             total/(double)SAMPLES);
    study_progress(what, 0, 0);
    memset(&f, 0, sizeof f);
    opened = (int)fmax(k, m->o.replay_from*SAMPLES + 0.5);
    for (begun = study_clock(), first = k; k < total && !bad; k++) {
        if (k == opened) {
            f = study_replay_open(m->world, m->o.replay ? REPLAY_FRAMES : 0, (total - k)*m->sample_steps*m->dt,
                          "A tumbling mill with lifters");
            mill_replay(m, &f, k, (since = k, &since));
        }
        if (frames && (int64_t)k*frames%total < frames)
            frame_write(m, (int)((int64_t)k*frames/total));
        bad = spectrum_begin(m, k, m->o.slabs) || mill_step(m, slabs);
        if (bad) break;
        sample_take(m, &m->samples[k + 1]);
        mill_replay(m, &f, k + 1, &since);
        count = k + 2;
        if (m->o.checkpoint && !study.quiet && ((k + 1)%(SAMPLES/4) == 0 || k + 1 == total))
            bad = samples_file(m, m->o.checkpoint, 1, &count) ||
                  refused(m->world, dem_checkpoint_write(m->world, m->o.checkpoint));
        study_progress(what, (k + 1 - first)/(double)(total - first), work*(k + 1 - first));
    }
    dem_slabs_destroy(slabs);
    study_replay_close(&f);
    if (bad) return 1;
    study_result("rate", work*(k - first)/fmax(study_clock() - begun, 1e-3), "particle-steps/s");
    if (frames) frame_write(m, frames);
    return 0;
}

/* ---- maps ---- */

/* n x n cells; NaN where no grain was. */
typedef struct map { int n; double *solid, *u, *v, *mass; } map;

static map map_make(const dem_field_data *d, int n) { /* cells of the field summed to n x n */
    map a;
    int i, j, k, step = CELLS/n;
    double **lists[4];
    lists[0] = &a.solid; lists[1] = &a.u; lists[2] = &a.v; lists[3] = &a.mass;
    for (k = 0; k < 4; k++) *lists[k] = (double *)study_alloc((size_t)n*(size_t)n, sizeof(double));
    a.n = n;
    for (j = 0; j < CELLS; j++)
        for (i = 0; i < CELLS; i++) {
            int from = i + CELLS*j;
            k = i/step + n*(j/step);
            a.solid[k] += d->solid[from]/((double)d->samples*step*step);
            a.mass[k] += d->mass[from];
            a.u[k] += d->momentum[3*from];
            a.v[k] += d->momentum[3*from + 1];
        }
    for (k = 0; k < n*n; k++) {
        if (!(a.mass[k] > 0)) a.solid[k] = (double)NAN;
        a.u[k] /= a.mass[k];
        a.v[k] /= a.mass[k];
    }
    return a;
}

static double map_bulk(const map *a) { /* mean over the cells above 0.4 */
    double sum = 0, count = 0;
    int i;
    for (i = 0; i < a->n*a->n; i++)
        if (a->solid[i] > 0.4) { sum += a->solid[i]; count++; }
    return sum/count;
}

/* Solid fraction on the ring inside the lifters, at an angle from straight down, over 4 degrees. */
static double map_ring(const mill *m, const map *a, double degrees) {
    double sum = 0, R = m->o.diameter/2;
    int k;
    for (k = 0; k < 81; k++) {
        double angle = (degrees - 2 + 0.5*(k%9))*PI/180, r = m->shell*(0.84 + 0.01*(k/9));
        int i = (int)((1 + r*sin(angle)/R)*a->n/2), j = (int)((1 - r*cos(angle)/R)*a->n/2);
        if (a->mass[i + a->n*j] > 0) sum += a->solid[i + a->n*j]/81;
    }
    return sum;
}
static void map_toe_shoulder(mill *m, const map *a) { /* in both directions from the fullest point of the ring */
    double best = 0, edge = m->solidicity/2, at;
    for (at = -180; at < 180; at++) if (map_ring(m, a, at) > map_ring(m, a, best)) best = at;
    for (at = best; at > best - 360 && map_ring(m, a, at) > edge;) at -= 0.5;
    m->toe = at;
    for (at = best; at < best + 360 && map_ring(m, a, at) > edge;) at += 0.5;
    m->shoulder = at;
}

/* Returns the mean solid fraction over a square of half the side `reach` (m) about a point; empty cells count as 0. */
static double map_near(const mill *m, const map *a, double x, double y, double reach) {
    const double R = m->o.diameter/2;
    const int i0 = (int)floor((1 + (x - reach)/R)*a->n/2), i1 = (int)floor((1 + (x + reach)/R)*a->n/2);
    const int j0 = (int)floor((1 + (y - reach)/R)*a->n/2), j1 = (int)floor((1 + (y + reach)/R)*a->n/2);
    double sum = 0;
    int i, j;
    for (j = j0; j <= j1; j++)
        for (i = i0; i <= i1; i++)
            if (i >= 0 && j >= 0 && i < a->n && j < a->n && a->mass[i + a->n*j] > 0) sum += a->solid[i + a->n*j];
    return sum/((i1 - i0 + 1)*(j1 - j0 + 1));
}
/* Returns how much the free surface is bent to an S: the amplitude of one sine over its chord, over the length of the chord;
   positive if the surface is below the chord near the toe and above it near the shoulder. The surface is where the solid
   fraction, a mean over a square of two bead diameters, exceeds half of the bulk's. The chord is between the two places where
   it does so on a circle three bead radii inside the shell. */
static double map_bend(const mill *m, const map *a) {
    enum { POINTS = 41 };
    const double R = m->o.diameter/2, bead = m->o.radius, r = m->shell - 3*bead, edge = m->solidicity/2;
    double best = 0, most = 0, at, end[2][2], sum = 0, length, tx, ty;
    int k;
    for (at = -180; at < 180; at++) {          /* the middle of the charge on the circle */
        double covered = 0, turn;
        for (turn = -40; turn <= 40; turn += 4)
            covered += map_near(m, a, r*sin((at + turn)*PI/180), -r*cos((at + turn)*PI/180), 2*bead);
        if (covered > most) { most = covered; best = at; }
    }
    for (k = 0; k < 2; k++) {
        for (at = best; fabs(at - best) < 180; at += k ? 0.5 : -0.5)
            if (map_near(m, a, r*sin(at*PI/180), -r*cos(at*PI/180), 2*bead) < edge) break;
        end[k][0] = r*sin(at*PI/180);
        end[k][1] = -r*cos(at*PI/180);
    }
    length = hypot(end[1][0] - end[0][0], end[1][1] - end[0][1]);
    tx = (end[1][0] - end[0][0])/length;
    ty = (end[1][1] - end[0][1])/length;
    for (k = 1; k + 1 < POINTS; k++) {
        const double s = length*k/(POINTS - 1);
        double h;
        for (h = 0.6*R; h > -0.6*R; h -= 0.002*R) {     /* from the free side */
            const double x = end[0][0] + tx*s - ty*h, y = end[0][1] + ty*s + tx*h;
            if (hypot(x, y) < r && map_near(m, a, x, y, 2*bead) > edge) break;
        }
        sum -= h/length*sin(2*PI*k/(POINTS - 1));
    }
    return 2*sum/(POINTS - 1);
}

static double map_shell_speed(const mill *m, const map *a) {
    double momentum = 0, mass = 0;
    int i;
    for (i = 0; i < a->n*a->n; i++) {
        double x = ((2*(i%a->n) + 1.0)/a->n - 1)*m->o.diameter/2;
        double y = ((2*(i/a->n) + 1.0)/a->n - 1)*m->o.diameter/2, angle = atan2(x, -y)*180/PI;
        if (hypot(x, y) < m->shell - 3*m->o.radius || !(a->mass[i] > 0)) continue;
        if (angle < m->toe + 20 || angle > m->shoulder - 20) continue;
        momentum += hypot(a->u[i], a->v[i])*a->mass[i];
        mass += a->mass[i];
    }
    return momentum/mass/(m->omega*m->shell);
}

/* Returns the share of the charge that flies or bounces at the toe: the mass in cells whose solid fraction is below half of the
   bulk's, within 45 degrees of the toe, from half the radius of the shell to three bead radii inside it. */
static double map_splash(const mill *m, const map *a) {
    double mass = 0, all = 0;
    int i;
    for (i = 0; i < a->n*a->n; i++) {
        double x = ((2*(i%a->n) + 1.0)/a->n - 1)*m->o.diameter/2;
        double y = ((2*(i/a->n) + 1.0)/a->n - 1)*m->o.diameter/2, r = hypot(x, y);
        all += a->mass[i];
        if (!(a->mass[i] > 0) || a->solid[i] > m->solidicity/2 || r < m->shell/2 || r > m->shell - 3*m->o.radius) continue;
        if (fabs(remainder(atan2(x, -y)*180/PI - m->toe, 360)) < 45) mass += a->mass[i];
    }
    return mass/all;
}

/* The mill, end on. */
static study_figure section_figure(const mill *m, const char *title, const char *bar_label) {
    study_figure f;
    memset(&f, 0, sizeof f);
    f.title = title;
    f.bar_label = bar_label;
    f.x_label = "x (m)";
    f.y_label = "y (m)";
    f.x1 = f.y1 = 1.01*m->o.diameter/2;
    f.x0 = f.y0 = -f.x1;
    f.equal = 1;
    return f;
}

static void maps_write(mill *m) {
    double circle[2][361], mark[2][2][2], R = m->o.diameter/2, fastest = 0;
    char title[128], name[64];
    dem_field_data d;
    map maps[3];
    int i, k;
    if (refused(m->world, dem_field_get(m->world, m->field, &d))) return;
    if (!d.samples) { study_fail("nothing was measured: --revolutions is too short"); return; }
    for (i = 0; i < 3; i++) maps[i] = map_make(&d, 64 << i);
    m->solidicity = map_bulk(&maps[0]);
    map_toe_shoulder(m, &maps[2]);
    study_result("solidicity_bulk", m->solidicity, "");
    fastest = map_shell_speed(m, &maps[2]);
    if (!m->o.brief || fastest > 0) study_result("shell_speed_ratio", fastest, "");
    fastest = 0;
    m->bend = map_bend(m, &maps[2]);
    study_result("bend", m->bend, "");
    study_result("toe", m->toe, "degrees");
    study_result("shoulder", m->shoulder, "degrees");
    study_result("splash", map_splash(m, &maps[1]), "");
    for (i = 0; i <= 360; i++) { circle[0][i] = R*sin(i*PI/180); circle[1][i] = R*cos(i*PI/180); }
    for (k = 0; k < 4; k++) { /* short lines to the shell at toe and shoulder */
        double angle = (k/2 ? m->shoulder : m->toe)*PI/180, r = k%2 ? R : 0.84*m->shell;
        mark[k/2][0][k%2] = r*sin(angle);
        mark[k/2][1][k%2] = -r*cos(angle);
    }
    for (k = 0; k < 64*64; k++)
        if (maps[0].mass[k] > 0) fastest = fmax(fastest, hypot(maps[0].u[k], maps[0].v[k]));
    for (i = 0; i < 6; i++) {
        int n = 64 << i/2;
        const char *of = i%2 ? "Velocity" : "Solidicity";
        study_figure f = section_figure(m, title, i%2 ? "speed (m/s)" : "solidicity");
        f.x1 = f.y1 = R;
        f.x0 = f.y0 = -R;
        f.nx = f.ny = n;
        f.hi = i%2 ? fastest : 0.7;
        if (i%2) { f.u = maps[i/2].u; f.v = maps[i/2].v; }
        else f.value = maps[i/2].solid;
        if (i%2) f.size = fmax(620, 4.84*n); /* room for the arrows */
        study_curve(&f, 0, STUDY_OUTLINE, 361, circle[0], circle[1]);
        for (k = 0; k < 2; k++) study_curve(&f, 0, STUDY_OUTLINE, 2, mark[k][0], mark[k][1]);
        snprintf(title, sizeof title, "%s at %.0f %% of critical, %d x %d cells", of,
                 100*m->o.speed, n, n);
        snprintf(name, sizeof name, "%s_%d.svg", i%2 ? "velocity" : "solidicity", n);
        study_figure_write(&f, name);
    }
    for (i = 0; i < 3; i++) {
        free(maps[i].solid); free(maps[i].u); free(maps[i].v); free(maps[i].mass);
    }
}

static void grains_draw(mill *m) { /* all grains of the slice, as they are at the end */
    dem_bodies b = dem_bodies_get(m->world);
    int i, k, points = m->profile.segment_count ? m->profile.vertex_count + 1 : 361;
    double *v[6];
    dem_pose pose;
    study_figure f = section_figure(m, "The charge at the end of the run", "speed (m/s)");
    if (refused(m->world, dem_wall_pose_get(m->world, m->walls[0], &pose))) return;
    for (k = 0; k < 6; k++)
        v[k] = (double *)study_alloc((size_t)(k < 4 ? b.count : points), sizeof(double));
    for (i = 0; i < b.count; i++) {
        const dem_real *u = b.velocities + 4*i;
        for (k = 0; k < 3; k++) v[k][i] = b.positions[4*i + (k < 2 ? k : 3)];
        v[3][i] = sqrt(u[0]*u[0] + u[1]*u[1] + u[2]*u[2]);
    }
    for (i = 0; i < 2*points; i++) { /* the shell, turned */
        const dem_real *p = m->profile.vertices + 2*(i/2%(points - 1));
        const dem_real *row = pose.rotation + 3*(i%2);
        if (m->profile.segment_count) v[4 + i%2][i/2] = row[0]*p[0] + row[1]*p[1];
        else v[4 + i%2][i/2] = m->shell*sin((i/2 + 90*(i%2))*PI/180);
    }
    f.disc_count = b.count;
    f.disc_x = v[0]; f.disc_y = v[1]; f.disc_r = v[2]; f.disc_value = v[3];
    study_curve(&f, 0, STUDY_OUTLINE, points, v[4], v[5]);
    study_figure_write(&f, "grains.svg");
    for (k = 0; k < 6; k++) free(v[k]);
}

/* ---- torque and energy ---- */

static study_figure line_figure(const char *title, const char *x_label, const char *y_label) {
    study_figure f;
    memset(&f, 0, sizeof f);
    f.title = title;
    f.x_label = x_label;
    f.y_label = y_label;
    return f;
}

static double window_torque(const sample *from, const sample *to) {
    return (to->impulse - from->impulse)/(to->time - from->time);
}
static double dissipated(const sample *s) {
    return s->ledger.normal + s->ledger.slide + s->ledger.tangent + s->ledger.rolling;
}
static double stored(const sample *s) { /* the elevation counts as the negative work of gravity */
    return s->ledger.kinetic + s->ledger.rotational + s->ledger.elastic - s->ledger.gravity;
}

static void torque_write(mill *m) {
    enum { COLUMNS = 16, TORQUE = 7 };
    int n = m->sample_count, half = SAMPLES/2, k, c, steady;
    const sample *s = m->samples, *a = s + m->settled, *b = s + n;
    double span = b->time - a->time, x = 0, weight, turned, loss, *column[COLUMNS];
    study_figure f;

    /* results */
    for (k = m->settled; k < n; k++) x += 0.5*(s[k].x + s[k + 1].x)/(n - m->settled);
    weight = m->mass*GRAVITY*x;
    loss = dissipated(b) - dissipated(a);
    m->torque = window_torque(a, b);
    m->power = m->torque*m->omega;
    turned = (b->angular - a->angular)/span;
    for (steady = n; steady >= half; steady--)
        if (!(fabs(window_torque(s + steady - half, s + steady)/m->torque - 1) < 0.05)) break;
    study_result("torque_mean", m->torque, "N m");
    study_result("torque_balance_error", fabs(m->torque - weight)/fabs(weight), "");
    study_result("momentum_balance_error", fabs(m->torque - weight - turned)/fabs(weight), "");
    study_result("centre_of_mass_x", x, "m");
    study_result("power_mean", m->power, "W");
    study_result("dissipation_rate", loss/span, "W");
    loss += stored(b) - stored(a);
    study_result("power_balance_error", fabs(m->power - loss/span)/fabs(m->power), "");
    study_result("steady_after", steady/(double)SAMPLES, "revolutions");

    /* files */
    for (c = 0; c < COLUMNS; c++) column[c] = (double *)study_alloc((size_t)n, sizeof(double));
    for (k = 0; k < n; k++) {
        const sample *p = s + k, *q = p + 1;
        const dem_ledger *l = &q->ledger;
        double step = q->time - p->time;
        int begin = k + 1 < half ? 0 : k + 1 - half;
        const double row[COLUMNS] = {
            q->time, q->time/m->period, window_torque(p, q), window_torque(s + begin, q),
            m->mass*GRAVITY*q->x, (q->work - p->work)/step, (dissipated(q) - dissipated(p))/step,
            q->time, l->kinetic, l->rotational, l->elastic, l->gravity, l->walls, l->normal,
            l->slide + l->tangent + l->rolling, l->residual};
        for (c = 0; c < COLUMNS; c++) column[c][k] = row[c];
    }
    study_csv("torque.csv", "time_s,revolutions,torque_Nm,torque_over_half_a_turn_Nm,mass_g_x_Nm,"
              "power_W,dissipation_W", n, TORQUE, (const double *const *)column);
    study_csv("ledger.csv", "time_s,kinetic_J,rotational_J,elastic_J,gravity_J,walls_J,dashpot_J,"
              "friction_J,residual_J", n, COLUMNS - TORQUE,
              (const double *const *)(column + TORQUE));
    f = line_figure("Torque of the mill on its charge", "revolutions", "torque (N m)");
    study_curve(&f, "at once", STUDY_FAINT, n, column[1], column[2]);
    study_curve(&f, "over the last half turn", STUDY_LINE, n, column[1], column[3]);
    study_curve(&f, "M g x", STUDY_DASHED, n, column[1], column[4]);
    study_figure_write(&f, "torque.svg");
    f = line_figure("Power", "revolutions", "power (W)");
    study_curve(&f, "of the mill", STUDY_FAINT, n, column[1], column[5]);
    study_curve(&f, "dissipated", STUDY_LINE, n, column[1], column[6]);
    study_figure_write(&f, "power.svg");
    for (c = 0; c < COLUMNS; c++) free(column[c]);
}

/* ---- contacts ---- */

/* Returns the part of the work of sliding on the shell that is done on the lifters: on segments whose
   middle is inside the circle of the shell by more than a hundredth of its radius. */
static double wear_on_lifters(const mill *m) {
    const dem_profile *p = &m->profile;
    double *work = (double *)study_alloc((size_t)p->segment_count + 1, sizeof *work), on = 0, all = 0;
    int i;
    dem_wall_wear_facets_get(m->world, m->walls[0], work, p->segment_count);
    for (i = 0; i < p->segment_count; i++) {
        const dem_real *a = p->vertices + 2*p->segments[2*i], *b = p->vertices + 2*p->segments[2*i + 1];
        all += work[i];
        if (hypot(a[0] + b[0], a[1] + b[1])/2 < 0.99*m->shell) on += work[i];
    }
    free(work);
    return on/fmax(all, 1e-300);
}
/* Spectra of the contacts between beads, and of beads with the shell. */
static void spectrum_write(mill *m) {
    static const char *const names[2] = {"bead on bead", "bead on shell"};
    const dem_material any = {0}, *other[2];
    const sample *last = &m->samples[m->sample_count];
    double lost, error;
    study_figure f = line_figure("Impacts in the mill", "energy of impact (J)", "impacts per second in a bin (1/s)");
    study_figure h = line_figure("Where the energy is lost", "energy lost in a contact (J)", "power in a bin (W)");
    static double x[DEM_IMPACT_BINS], y[2][2][DEM_IMPACT_BINS];
    dem_impacts s;
    int i, k;
    other[0] = &m->glass;
    other[1] = &m->lining;
    if (refused(m->world, dem_impacts_get(m->world, any, any, &s))) return;
    /* a run that was resumed began to record earlier */
    lost = dissipated(last) - dissipated(last - (int)(s.seconds/m->period*SAMPLES + 0.5));
    study_result("contact_rate", s.rate, "1/s");
    error = fabs(s.lost_normal + s.lost_slide + s.lost_tangent + s.lost_rolling - lost)/lost;
    study_result("event_balance_error", error, "");
    if (!(error <= 1e-3)) study_fail("the contacts lost %g of the energy more or less than the ledger says", error);
    f.log_x = f.log_y = h.log_x = 1;
    f.x0 = 1e300;
    for (k = 0; k < (m->glass.id == m->lining.id ? 1 : 2); k++) {
        if (refused(m->world, dem_impacts_get(m->world, m->glass, *other[k], &s))) return;
        for (i = 0; i < DEM_IMPACT_BINS; i++) {
            x[i] = sqrt(s.bin[i]*s.bin[i + 1]);
            y[0][k][i] = s.impacts[i] > 0 ? s.impacts[i]/s.seconds : (double)NAN;
            y[1][k][i] = s.energy[i]/s.seconds;
            if (s.impacts[i] > 0) { f.x0 = fmin(f.x0, s.bin[i]); f.x1 = fmax(f.x1, s.bin[i + 1]); }
            if (s.energy[i] > 0) h.x1 = fmax(h.x1, s.bin[i + 1]);
            if (y[0][k][i] > 0) f.y1 = fmax(f.y1, 2*y[0][k][i]);
            h.y1 = fmax(h.y1, 1.1*y[1][k][i]);
        }
        study_curve(&f, names[k], k ? STUDY_DASHED : STUDY_LINE, DEM_IMPACT_BINS, x, y[0][k]);
        study_curve(&h, names[k], k ? STUDY_DASHED : STUDY_LINE, DEM_IMPACT_BINS, x, y[1][k]);
    }
    /* ranges of logarithmic axes are logarithms; rarer and weaker impacts are left out */
    f.x1 = log10(f.x1);
    f.x0 = fmax(log10(f.x0), f.x1 - 9);
    f.y1 = log10(f.y1);
    f.y0 = f.y1 - 4;
    h.x1 = log10(h.x1);
    h.x0 = h.x1 - 7;
    study_figure_write(&f, "spectrum.svg");
    study_figure_write(&h, "losses.svg");
    if (!study.quiet) study.files += !refused(m->world, dem_impacts_csv_write(m->world, study_path("impacts.csv")));
    if (m->profile.segment_count) study_result("wear_on_lifters", wear_on_lifters(m), "");
}

static void state_write(mill *m) { /* results of the whole run */
    dem_ledger ledger = dem_ledger_get(m->world);
    dem_body_counts balance = dem_body_counts_get(m->world);
    dem_bodies b = dem_bodies_get(m->world);
    char text[32];
    FILE *report;
    int i;
    double missing = (double)balance.inserted - (double)balance.present;
    for (i = 0; i < b.count; i++)
        if (hypot(b.positions[4*i], b.positions[4*i + 1]) > m->o.diameter/2) missing++;
    study_result("overlap_max", dem_counters_get(m->world).overlap_max, "");
    study_result("ledger_residual", fabs(ledger.residual)/ledger.throughput, "");
    study_result("grains_missing", missing, "");
    if (missing != 0) study_fail("%g grains got lost", missing);
    snprintf(text, sizeof text, "%016llx", (unsigned long long)dem_world_hash_get(m->world));
    study_result_text("hash", text, "");
    report = study_open("report.txt");
    if (report) dem_world_report(m->world, report);
    study_close(report, "report.txt");
}

static int mill_run(mill *m) {
    int bad = mill_begin(m);
    if (!bad) {
        study_result("grains", m->grains, "");
        study_result("dt", m->dt, "s");
        study_result("speed_critical", m->critical, "rad/s");
        study_result("omega", m->omega, "rad/s");
        bad = mill_turn(m);
    }
    if (!bad) { maps_write(m); torque_write(m); grains_draw(m); state_write(m); }
    if (!bad && m->recorded) spectrum_write(m);
    free(m->samples);
    mill_destroy(m);
    return bad;
}

/* Several mills: 60, 70, 80 % of critical (Fig 6.7 to 6.12), or beads of three frictions in a smooth drum lined with beads at
   50 % (Fig 6.13); or other values. Means over --repeats seeds, with standard errors. */
static int study_several(int friction) {
    enum { MOST = 12, MEASURED = 5 };
    static const char *const names[MEASURED] = {"torque", "power", "toe", "shoulder", "solidicity"};
    static const char *const units[MEASURED] = {"N m", "W", "degrees", "degrees", ""};
    double value[MOST], column[2*MEASURED][MOST];
    const double *columns[1 + 2*MEASURED] = {value};
    const int runs = runs_of(1);
    int i, k, n, count;
    for (i = 0; i < 3; i++) value[i] = friction ? 0.42 + 0.02*i : 0.6 + 0.1*i;
    count = study_values_take(options.values, 0, value, 3, MOST);
    for (i = 0; i < count; i++) {
        struct mill_options o = options;
        *(friction ? &o.friction : &o.speed) = value[i];
        o.seed += runs - 1;
        if (!study_within(table, OPTIONS, &options, &o)) return 1;
    }
    for (k = 0; k < 2*MEASURED; k++) columns[1 + k] = column[k];
    for (i = 0; i < count; i++) {
        double found[MEASURED][REPEATS];
        char part[48];
        for (n = 0; n < runs; n++) {
            mill m;
            memset(&m, 0, sizeof m);
            m.o = options;
            m.o.seed += n;
            m.o.speed = friction ? 0.5 : value[i];
            if (friction) { m.o.wall = "grains"; m.o.friction = value[i]; }
            snprintf(part, sizeof part, runs > 1 ? "%s_%.4g_seed%d" : "%s_%.4g", friction ? "friction" : "speed",
                     100*value[i], m.o.seed);
            study_part(part);
            if (mill_run(&m)) return 1;
            found[0][n] = m.torque; found[1][n] = m.power; found[2][n] = m.toe; found[3][n] = m.shoulder;
            found[4][n] = m.solidicity;
        }
        study_part("");
        for (k = 0; k < MEASURED; k++) {
            snprintf(part, sizeof part, "%s_%.4g.%s", friction ? "friction" : "speed", 100*value[i], names[k]);
            column[2*k][i] = study_mean(found[k], runs, 1, &column[2*k + 1][i]);
            if (runs > 1) study_mean_tell(part, found[k], runs, units[k]);
        }
    }
    if (count)
        study_csv("comparison.csv", "speed_or_friction,torque_Nm,error,power_W,error,toe_deg,error,shoulder_deg,error,"
                  "solidicity,error", count, 1 + 2*MEASURED, columns);
    return 0;
}

/* The S of Fig 6.13 and its control: spheres of ordinary friction in smooth, lined and lifted shells and at other speeds,
   beside spheres of high friction and shaped grains of the same volume. Means and standard errors over seeds. */
static int study_control(void) {
    static const struct { const char *name, *profile, *wall, *grains; double friction, aspect, speed; } cases[] = {
        {"smooth", "none", "mesh", "sphere", 0.154, 1, 0.5},
        {"lifters", "lifters", "mesh", "sphere", 0.154, 1, 0.5},
        {"lined", "none", "grains", "sphere", 0.154, 1, 0.5},
        {"lined_slow", "none", "grains", "sphere", 0.154, 1, 0.3},
        {"lined_fast", "none", "grains", "sphere", 0.154, 1, 0.7},
        {"rough", "none", "grains", "sphere", 0.44, 1, 0.5},
        {"pair", "none", "grains", "pair", 0.154, 1.5, 0.5},
        {"tetra", "none", "grains", "tetra", 0.154, 1, 0.5}};
    static const struct { const char *name, *unit; } names[4] = {
        {"bend", ""}, {"torque", "N m"}, {"shoulder", "degrees"}, {"toe", "degrees"}};
    const int runs = runs_of(3);
    size_t i;
    int k, n;
    for (i = 0; i < sizeof cases/sizeof *cases; i++) {
        double found[4][REPEATS];
        char text[64];
        for (n = 0; n < runs; n++) {
            mill m;
            memset(&m, 0, sizeof m);
            m.o = options;
            m.o.seed += n;
            m.o.profile = cases[i].profile; m.o.wall = cases[i].wall; m.o.grains = cases[i].grains;
            m.o.friction = cases[i].friction; m.o.aspect = cases[i].aspect; m.o.speed = cases[i].speed;
            snprintf(text, sizeof text, "%s_seed%d", cases[i].name, m.o.seed);
            study_part(text);
            if (mill_run(&m)) return 1;
            found[0][n] = m.bend; found[1][n] = m.torque; found[2][n] = m.shoulder; found[3][n] = m.toe;
        }
        study_part("");
        for (k = 0; k < 4; k++) {
            snprintf(text, sizeof text, "%s.%s", cases[i].name, names[k].name);
            study_mean_tell(text, found[k], runs, names[k].unit);
        }
    }
    return 0;
}

/* The same mill with fields of several resolutions and without one, all stepped in turns: the processor time of each over
   that without a field, and the time of a step over the run. */
static int study_fields(void) {
    enum { MILLS = 5, ROUNDS = 1000 };
    static const int cells[MILLS] = {-1, 64, 128, 256, 512};
    static double spent[MILLS][ROUNDS], turn[ROUNDS], pace[ROUNDS];
    const double *columns[2] = {turn, pace};
    mill m[MILLS];
    char text[64];
    int i, k, rounds = 0, window;
    options.threads = 1;
    memset(m, 0, sizeof m);
    for (i = 0; i < MILLS; i++) {
        m[i].o = options;
        m[i].o.settle = 0;                       /* the field begins with the run */
        m[i].cells = cells[i];
        if (mill_begin(&m[i])) return 1;
    }
    window = options.brief ? 1 : SAMPLES/20;     /* a twentieth of a revolution */
    for (k = 0; k < (options.settle + options.revolutions)*SAMPLES && rounds < ROUNDS; k += window, rounds++) {
        for (i = 0; i < MILLS; i++) {
            const clock_t begun = clock();
            if (refused(m[i].world, dem_world_step(m[i].world, window*m[i].sample_steps))) return 1;
            spent[i][rounds] = (double)(clock() - begun)/CLOCKS_PER_SEC/(window*m[i].sample_steps);
        }
        turn[rounds] = (k + window)/(double)SAMPLES;
        pace[rounds] = 1e6*spent[0][rounds];
        study_progress("fields", fmin(1, turn[rounds]/(options.settle + options.revolutions)), 0);
    }
    study_result("grains", m[0].grains, "");
    for (i = 1; i < MILLS; i++) {
        double ratio[ROUNDS], mean = 0, square = 0;
        for (k = 0; k < rounds; k++) {
            const double before = mean;
            ratio[k] = spent[i][k]/fmax(spent[0][k], 1e-9);
            mean += (ratio[k] - before)/(k + 1);
            square += (ratio[k] - before)*(ratio[k] - mean);
        }
        snprintf(text, sizeof text, "cells%d.time", cells[i]);
        study_result(text, mean, "of a run without a field");
        snprintf(text, sizeof text, "cells%d.time_error", cells[i]);
        if (rounds > 1) study_result(text, sqrt(square/(rounds - 1)/rounds), "");
    }
    study_result("first_step", pace[0], "microseconds");
    study_result("last_step", pace[rounds - 1], "microseconds");
    study_csv("pace.csv", "revolutions,step_microseconds", rounds, 2, columns);
    for (i = 0; i < MILLS; i++) {
        if (memcmp(dem_bodies_get(m[i].world).positions, dem_bodies_get(m[0].world).positions,
                   4*(size_t)m[0].grains*sizeof(dem_real)))
            study_fail("a field of %d cells changes the run", cells[i]);
    }
    for (i = 0; i < MILLS; i++) mill_destroy(&m[i]);
    return 0;
}

/* Section 5.2.10: checkpoints of the mill after --settle revolutions, in a slice of --length and in one twice as thick. The
   difference is what a bead adds; the rest does not depend on their number. */
static int study_backup(void) {
    double size[2], grains[2], slope;
    int i;
    for (i = 0; i < 2; i++) {
        FILE *file;
        mill m;
        memset(&m, 0, sizeof m);
        m.o = options;
        m.o.length *= i + 1;
        m.cells = -1;
        if (mill_begin(&m) || refused(m.world, dem_world_step(m.world, m.settled*m.sample_steps)) ||
            refused(m.world, dem_checkpoint_write(m.world, study_path("mill.checkpoint")))) return 1;
        file = fopen(study_path("mill.checkpoint"), "rb");
        if (!file || fseek(file, 0, SEEK_END)) { study_fail("cannot read the checkpoint"); return 1; }
        size[i] = (double)ftell(file);
        fclose(file);
        remove(study_path("mill.checkpoint"));
        grains[i] = m.grains;
        if (i) study_result("contacts", (double)dem_contacts_get(m.world, 0, 0)/m.grains, "per bead");
        if (i) study_result("candidates", (double)dem_counters_get(m.world).candidates/m.grains, "per bead");
        mill_destroy(&m);
    }
    slope = (size[1] - size[0])/(grains[1] - grains[0]);
    study_result("checkpoint", slope, "bytes per bead");
    study_result("checkpoint_303156", (size[0] + slope*(303156 - grains[0]))/1e6, "MB, extrapolated; [MIL]: 47");
    return 0;
}

/* ---- one bead ---- */

static dem_body bead_add(mill *m, double y, double vx, double vy) {
    dem_body bead = dem_sphere_add(m->world, m->glass, m->o.radius, dem_vec3_make(0, y, 0));
    dem_body_state s;
    if (!bead.slot || refused(m->world, dem_body_get(m->world, bead, &s))) return bead;
    s.velocity = dem_vec3_make(vx, vy, 0);
    refused(m->world, dem_body_set(m->world, bead, &s));
    return bead;
}

/* Throws a bead of true stiffness onto a flat sheet. In the standard mode the sheet is of the same glass. The mode of the
   thesis uses its arithmetic: E* = E, R/2 and m/2 against walls; friction without history; steps of 1e-6 s, in which its
   program moves with the velocity just updated (its text says forward Euler, which gives 0.70 to 0.72). Its sheet has the
   coefficients that Fig 5.23 gives for the mill (ps). Their damping is that of a restitution of 0.55 for half of the
   bead's mass; for the whole mass it gives 0.658.
   log: time, height, vertical and horizontal velocity, spin. */
typedef struct throw_of { const char *title; double height, vx, vy, time; } throw_of;
enum { ROWS = 2000 };

/* Makes a world for a few beads, with the convention, scheme and friction of the thesis if `thesis`. Returns 1 on an error. */
static int beads_world(mill *m, dem_world_desc *desc, int thesis) {
    memset(m, 0, sizeof *m);
    m->o = options;
    m->o.stiffness = "true";
    desc->gravity.y = -GRAVITY;
    desc->impact_speed = 0.5;
    desc->threads = 1;
    if (thesis) {
        desc->convention = DEM_CONVENTION_MILL;
        desc->integrator = DEM_INTEGRATOR_SYMPLECTIC_EULER;
        desc->tangent_law = DEM_TANGENT_STEP;
    }
    return world_create(m, desc) || materials_add(m);
}
static int throw_bead(const throw_of *t, int figure, int thesis, double *const *log,
                      double worst[3]) {
    dem_world_desc desc = DEM_WORLD_DESC;
    double before_gap = 0, before_v = 0, in = 0;
    int k, steps, bounces = 0, stride, straight = !(fabs(t->vx) > 0);
    char name[64];
    dem_body bead;
    mill m;
    desc.dt = thesis ? 1e-6 : 1e-7;
    desc.allow_large_dt = thesis;
    if (beads_world(&m, &desc, thesis)) return 1;
    dem_wall_plane_add(m.world, thesis ? m.lining : m.glass, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 1, 0));
    bead = bead_add(&m, m.o.radius + t->height, t->vx, t->vy);
    steps = (int)((options.brief ? 0.05 : t->time)/desc.dt + 0.5);      /* 0.05 s: one bounce, or two */
    stride = steps/ROWS;
    for (k = 0; k < steps; k++) {
        dem_body_state s;
        double gap, v;
        if (refused(m.world, dem_body_get(m.world, bead, &s))) return 1;
        gap = s.position.y - m.o.radius;
        v = s.velocity.y;
        if (k && gap < 0 && before_gap >= 0) in = sqrt(before_v*before_v + 2*GRAVITY*before_gap);
        if (gap >= 0 && before_gap < 0 && ++bounces <= 3) { /* speeds are those at height 0 */
            double e = sqrt(v*v + 2*GRAVITY*gap)/in;
            snprintf(name, sizeof name, "restitution_6_%d_bounce_%d_%s", figure, bounces,
                     thesis ? "thesis" : "standard");
            study_result(name, e, "");
            if (!thesis) worst[0] = fmax(worst[0], fabs(e - 0.66));
        }
        before_gap = gap;
        before_v = v;
        if (straight) {
            worst[1] = fmax(worst[1], fabs(s.velocity.x) + fabs(s.velocity.z));
            worst[2] = fmax(worst[2], fabs(s.spin.x) + fabs(s.spin.y) + fabs(s.spin.z));
        }
        if (k%stride == 0 && k/stride < ROWS) {
            const double row[5] = {k*desc.dt, s.position.y, v, s.velocity.x, s.spin.z};
            int c;
            for (c = 0; c < 5; c++) log[c][k/stride] = row[c];
        }
        if (refused(m.world, dem_world_step(m.world, 1))) return 1;
    }
    mill_destroy(&m);
    return 0;
}

static int study_drop(void) { /* Fig 6.1 to 6.6 */
    static const throw_of throws[6] = {
        {"dropped from rest", 0.005, 0, 0, 0.2}, {"thrown up", 0.005, 0, 0.2, 0.2},
        {"thrown down", 0.005, 0, -0.2, 0.2}, {"thrown to the right", 0.005, 0.2, 0, 0.2},
        {"thrown to the left", 0.005, -0.2, 0, 0.2},
        {"thrown to the right from higher up", 0.02, 0.5, 0, 0.4}};
    static const char *const names[4] = {"height", "vertical", "horizontal", "spin"};
    static const char *const labels[4] = {"height of the centre (m)", "vertical velocity (m/s)",
                                          "horizontal velocity (m/s)", "spin (rad/s)"};
    double *log[10], worst[3] = {0, 0, 0};
    char name[96], title[96];
    int t, c;
    for (c = 0; c < 10; c++) log[c] = (double *)study_alloc(ROWS, sizeof(double));
    for (t = 0; t < 6; t++) {
        for (c = 0; c < 2; c++) {
            if (throw_bead(&throws[t], t + 1, c, log + 5*c, worst)) return 1;
            snprintf(name, sizeof name, "drop_6_%d_%s.csv", t + 1, c ? "thesis" : "standard");
            study_csv(name, "time_s,height_m,vertical_m_s,horizontal_m_s,spin_rad_s", ROWS, 5,
                      (const double *const *)(log + 5*c));
        }
        for (c = 0; c < (t < 3 ? 2 : 4); c++) {
            study_figure f = line_figure(title, "time (s)", labels[c]);
            snprintf(title, sizeof title, "A glass bead %s", throws[t].title);
            study_curve(&f, "standard", STUDY_LINE, ROWS, log[0], log[1 + c]);
            study_curve(&f, "as in the thesis", STUDY_DASHED, ROWS, log[5], log[6 + c]);
            snprintf(name, sizeof name, "drop_6_%d_%s.svg", t + 1, names[c]);
            study_figure_write(&f, name);
        }
    }
    study_result("restitution_error_max", worst[0], "");
    study_result("sideways_max", worst[1], "m/s");
    study_result("spin_max", worst[2], "rad/s");
    if (worst[0] > 0.002) study_fail("restitution is off by %g", worst[0]);
    if (worst[1] > 0 || worst[2] > 0) study_fail("a bead that fell straight went sideways or spun");
    for (c = 0; c < 10; c++) free(log[c]);
    return 0;
}

/* Fig 4.5: a bead falls from rest, three radii above the centre of a fixed bead. The first contact step by step, and the
   height and velocity for 0.1 s; in the mode of the thesis and in the standard mode, both with its step of 1e-6 s. */
static int study_rebound(void) {
    static const char *const modes[2] = {"standard", "thesis"};
    enum { STEPS = 100000, STRIDE = 50, CONTACT = 60 };
    double *log[6];
    static double force[2][2][60];
    study_figure f[3];
    int mode, k, c;
    f[2] = line_figure("The first contact", "step of 1 microsecond", "force on the bead (N)");
    f[0] = line_figure("A bead dropped on a fixed bead", "time (s)", "height of the centre (m)");
    f[1] = line_figure("A bead dropped on a fixed bead", "time (s)", "vertical velocity (m/s)");
    for (c = 0; c < 6; c++) log[c] = (double *)study_alloc(STEPS/STRIDE, sizeof(double));
    for (mode = 0; mode < 2; mode++) {
        double speed = 0, highest = 0, impact = 0, most = 0;
        const double *columns[2] = {force[mode][0], force[mode][1]};
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_body_state s;
        dem_body bead, fixed;
        int touched = 0, contact = 0, attracting = 0, bounces = 0, steps = options.brief ? STEPS/4 : STEPS;
        char name[64];
        mill m;
        desc.dt = 1e-6;
        desc.allow_large_dt = 1;
        desc.tension = DEM_TENSION_ALLOWED;
        if (beads_world(&m, &desc, mode)) return 1;
        fixed = bead_add(&m, 0, 0, 0);
        bead = bead_add(&m, 3*m.o.radius, 0, 0);
        if (refused(m.world, dem_body_get(m.world, fixed, &s))) return 1;
        s.fixed = 1;
        if (refused(m.world, dem_body_set(m.world, fixed, &s))) return 1;
        for (k = 0; k < steps; k++) {
            dem_contact_info touch;
            if (refused(m.world, dem_body_get(m.world, bead, &s))) return 1;
            if (k%STRIDE == 0) {
                log[3*mode][k/STRIDE] = k*desc.dt;
                log[3*mode + 1][k/STRIDE] = s.position.y;
                log[3*mode + 2][k/STRIDE] = s.velocity.y;
            }
            if (s.position.y > 2*m.o.radius) {
                if (touched && !bounces++) impact = s.velocity.y;
                touched = 0;
                if (bounces == 1) highest = fmax(highest, s.position.y);
            } else {
                if (!touched && !bounces) speed = s.velocity.y;
                touched = 1;
                if (!bounces && contact < CONTACT && dem_contacts_get(m.world, &touch, 1) == 1) {
                    /* the force on the bead that falls, upwards */
                    const double up = touch.a.slot == bead.slot ? touch.force.y : -touch.force.y;
                    force[mode][0][contact] = contact + 1;
                    force[mode][1][contact++] = up;
                    most = fmax(most, up);
                    attracting += up < 0;
                }
            }
            if (refused(m.world, dem_world_step(m.world, 1))) return 1;
        }
        study_result(mode ? "contact_steps_thesis" : "contact_steps_standard", contact, "");
        study_result(mode ? "attracting_steps_thesis" : "attracting_steps_standard", attracting, "");
        study_result(mode ? "force_most_thesis" : "force_most_standard", most, "N");
        study_result(mode ? "impact_speed_thesis" : "impact_speed_standard", -speed, "m/s");
        study_result(mode ? "restitution_thesis" : "restitution_standard", -impact/speed, "");
        study_result(mode ? "apex_thesis" : "apex_standard", highest, "m");
        study_result(mode ? "bounces_thesis" : "bounces_standard", bounces, "");
        if (fabs(-impact/speed - 0.66) > 0.02) study_fail("restitution is %g instead of 0.66", -impact/speed);
        snprintf(name, sizeof name, "rebound_%s.csv", modes[mode]);
        study_csv(name, "time_s,height_m,velocity_m_s", steps/STRIDE, 3, (const double *const *)(log + 3*mode));
        snprintf(name, sizeof name, "rebound_force_%s.csv", modes[mode]);
        study_csv(name, "step,force_N", contact, 2, columns);
        for (c = 0; c < 2; c++)
            study_curve(&f[c], modes[mode], mode ? STUDY_DASHED : STUDY_LINE, steps/STRIDE, log[3*mode], log[3*mode + 1 + c]);
        study_curve(&f[2], modes[mode], mode ? STUDY_DASHED : STUDY_LINE, contact, columns[0], columns[1]);
        mill_destroy(&m);
    }
    study_figure_write(&f[0], "rebound_height.svg");
    study_figure_write(&f[1], "rebound_velocity.svg");
    study_figure_write(&f[2], "rebound_force.svg");
    for (c = 0; c < 6; c++) free(log[c]);
    return 0;
}

/* Section 5.2.1: a bead falls 5 mm on a flat sheet made of wall grains, at random places of the sheet. Sheets are square
   lattices: grains of several sizes that just touch, and grains of the size of the bead that overlap, with their forces
   divided by the number of grains on the area that one would cover. Means and spreads over --repeats places. */
static int study_sheet(void) {
    /* radius and spacing over the radius of the bead; 0: a plane */
    static const struct { const char *name; double radius, spacing; int divided; } sheets[] = {
        {"plane", 0, 0, 0}, {"touching_1", 1, 2, 0}, {"touching_2", 0.5, 1, 0}, {"touching_4", 0.25, 0.5, 0},
        {"touching_8", 0.125, 0.25, 0}, {"overlapping_4", 1, 0.4, 1}, {"overlapping_2", 1, 0.2, 1},
        {"overlapping_1", 1, 0.1, 1}, {"overlapping_1_undivided", 1, 0.1, 0}};
    enum { SHEETS = sizeof sheets/sizeof *sheets };
    static const char *const names[4] = {"restitution", "sideways", "overlap", "contact"};
    static const char *const units[4] = {"", "of the impact speed", "of the radius", "microseconds"};
    int i, n, c, x, y;
    for (i = 0; i < SHEETS; i++) {
        double mean[4] = {0, 0, 0, 0}, square[4] = {0, 0, 0, 0};
        const double r = options.radius, step = sheets[i].spacing*r, impact = sqrt(2*GRAVITY*0.005);
        const int side = sheets[i].radius > 0 ? (int)(1.5*r/step) + 2 : 0, places = sheets[i].radius > 0 ? runs_of(3) : 1;
        dem_real *at = (dem_real *)study_alloc(3*(size_t)((2*side + 1)*(2*side + 1)), sizeof *at);
        uint32_t random = (uint32_t)options.seed;
        char text[64];
        for (n = 0; n < places; n++) {
            const double offset[2] = {step*chance(&random), step*chance(&random)};
            double found[4] = {0, 0, 0, 0};
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_body_state s;
            dem_body bead;
            dem_wall wall;
            int count = 0, touched = 0, k;
            mill m;
            memset(&m, 0, sizeof m);
            m.o = options;
            m.o.stiffness = "true";
            m.o.friction = 0;               /* the sheet's shape alone */
            desc.impact_speed = impact;
            desc.threads = 1;
            desc.dt = 1e-7;
            desc.allow_large_dt = 1;
            if (world_create(&m, &desc) || materials_add(&m)) return 1;
            for (x = -side; x <= side; x++)
                for (y = -side; y <= side; y++) {
                    at[3*count] = offset[0] + x*step;
                    at[3*count + 1] = -sheets[i].radius*r;
                    at[3*count++ + 2] = offset[1] + y*step;
                }
            if (side) wall = dem_wall_grains_add(m.world, m.glass, count, at, sheets[i].radius*r,
                                                 sheets[i].divided ? pow(sheets[i].spacing/2, 2) : 1);
            else wall = dem_wall_plane_add(m.world, m.glass, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 1, 0));
            if (!wall.id) return refused(m.world, DEM_ERROR_ARGUMENT);
            bead = bead_add(&m, 1.0001*r, 0, -impact);
            for (k = 0; k < 100000; k++) {
                if (refused(m.world, dem_world_step(m.world, 1)) || refused(m.world, dem_body_get(m.world, bead, &s))) return 1;
                if (dem_contacts_get(m.world, 0, 0) > 0) { touched = 1; found[3] += 1e6*desc.dt; }
                else if (touched || s.position.y < -r) break;
            }
            found[0] = s.velocity.y/impact;
            found[1] = hypot(s.velocity.x, s.velocity.z)/impact;
            found[2] = dem_counters_get(m.world).overlap_max;
            if (!touched || found[0] <= 0) study_fail("sheet %s: the bead does not rebound", sheets[i].name);
            if (!side && fabs(found[0] - 0.66) > 0.002) study_fail("restitution on a plane is %g instead of 0.66", found[0]);
            for (c = 0; c < 4; c++) {
                const double old = mean[c];
                mean[c] += (found[c] - old)/(n + 1);
                square[c] += (found[c] - old)*(found[c] - mean[c]);
            }
            mill_destroy(&m);
        }
        free(at);
        for (c = 0; c < 4; c++) {
            snprintf(text, sizeof text, "%s.%s", sheets[i].name, names[c]);
            study_result(text, mean[c], units[c]);
            snprintf(text, sizeof text, "%s.%s_spread", sheets[i].name, names[c]);
            if (places > 1) study_result(text, sqrt(square[c]/(places - 1)), units[c]);
        }
    }
    return 0;
}

static int study_overlap(void) { /* Fig 6.0: a bead hits another, or the mill, head on */
    static const char *const names[4] = {"bead on bead, true", "bead on mill, true",
                                         "bead on bead, softened", "bead on mill, softened"};
    static const char *const results[4] = {"overlap_bead_true", "overlap_mill_true",
                                           "overlap_bead_soft", "overlap_mill_soft"};
    enum { SPEEDS = 25 };
    double column[5][SPEEDS];
    const double *columns[5] = {column[0], column[1], column[2], column[3], column[4]};
    study_figure f = line_figure("Largest overlap against impact speed", "impact speed (m/s)",
                                 "overlap (% of the radius)");
    int i, k;
    for (k = 0; k < 4; k++) {
        for (i = 0; i < SPEEDS; i++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_advice advice;
            double v = column[0][i] = 0.1*(i + 1), r = 1.001*options.radius, span;
            mill m;
            memset(&m, 0, sizeof m);
            m.o = options;
            m.o.stiffness = k < 2 ? "true" : "soft";
            desc.impact_speed = v;
            desc.threads = 1;
            if (world_create(&m, &desc) || materials_add(&m)) return 1;
            bead_add(&m, r, 0, k%2 ? -v : -v/2);
            if (!(k%2)) bead_add(&m, -r, 0, v/2);
            else dem_wall_plane_add(m.world, m.lining, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 1, 0));
            if (refused(m.world, dem_step_advice_get(m.world, &advice))) return 1;
            span = 2*advice.contact_time + 0.003*r/v;
            if (refused(m.world, dem_world_run(m.world, span, 0, 0))) return 1;
            column[k + 1][i] = 100*dem_counters_get(m.world).overlap_max;
            mill_destroy(&m);
        }
        study_curve(&f, names[k], k < 2 ? STUDY_LINE : STUDY_DASHED, SPEEDS, column[0],
                    column[k + 1]);
        study_result(results[k], column[k + 1][11]/100, "at 1.2 m/s");
    }
    study_csv("overlap.csv", "speed_m_s,bead_true_percent,mill_true_percent,bead_soft_percent,"
              "mill_soft_percent", SPEEDS, 5, columns);
    study_figure_write(&f, "overlap.svg");
    return 0;
}

int main(int argc, char **argv) {
    const char *about = "A tumbling mill with lifters, filled with glass beads.";
    mill m;
    program_path = argv[0];
    study_options(argc, argv, about, table, OPTIONS);
    if (options.quick) { /* a smaller mill of fewer, softer beads; options given by name keep their values */
        options.diameter = 0.12;
        options.fill = 0.3;
        options.soften = 1000;
        options.contact_steps = 30;
        options.revolutions = 0.6;
        study_options(argc, argv, about, table, OPTIONS);
    }
    if (options.first) { /* beads of 6 mm; the slice remains 2.3 beads thick */
        options.radius = 0.003;
        options.length = 0.0136;
        options.replay_from = options.settle;
        study_options(argc, argv, about, table, OPTIONS);
    }
    if (options.brief) {
        options.replay_from = 0;
        options.diameter = options.first ? 0.24 : 0.12; /* as many beads in either */
        options.length = fmin(options.length, 0.03);    /* of the whole mill, too */
        options.soften = 1000;
        options.settle = options.revolutions = 0.05;
        options.frames = 0;
        options.repeats = 1;
    }
    if (options.write_profile) return profile_write(options.write_profile);
    study_begin(options.out);
    memset(&m, 0, sizeof m);
    m.o = options;
    if (!is(options.study, "speeds") && !is(options.study, "friction")) study_values_unused(options.values, "this study");
    if (is(options.study, "mill")) mill_run(&m);
    if (is(options.study, "drop")) study_drop();
    if (is(options.study, "rebound")) study_rebound();
    if (is(options.study, "sheet")) study_sheet();
    if (is(options.study, "overlap")) study_overlap();
    if (is(options.study, "speeds")) study_several(0);
    if (is(options.study, "friction")) study_several(1);
    if (is(options.study, "control")) study_control();
    if (is(options.study, "fields")) study_fields();
    if (is(options.study, "backup")) study_backup();
    return study_end();
}
