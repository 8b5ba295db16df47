/* ellipsoids.c - a gas of ellipsoids that cools as they collide.

   The gas is that of [RUB15] section 4, a granular gas of ellipsoids on a GPU: 4096 frictionless
   prolate ellipsoids of elongation xi = a/b fill 0.058 of a periodic cube of 2 m. 2000 kg/m3,
   k = 1e8 N/m, restitution 0.90, 0.95, 0.98, time step t_c/50 (t_c: duration of a contact), a cubic
   lattice with Gaussian velocities and spins at the start, a run-in without damping. Differences:
     - Axes follow from xi and the volume fraction. Table 1 gives them in sixteenths of a metre (as
       metres they would not fit into the cube), and its row xi = 1.25 repeats the a of the row above,
       0.527 instead of 0.557.
     - [RUB15] does not give the initial speeds. Here a typical collision (root mean square of the
       speed of approach) overlaps by --overlap, 0.003 of the radius of the sphere of equal volume. It
       lasts 0.003 of the time between two collisions, so few collisions overlap in time.
     - The restitution is the given one for any inertia of the bodies at the contact. The damping of
       [RUB15] uses the reduced mass m/2. The mass that counts is 1/(n.K n), smaller by 1 + D for
       bodies that can rotate, so the ellipsoids of [RUB15] lose more energy than e_n states.
       --damping reduced uses that damping and that overlap.
     - By default there are 512 ellipsoids at the same volume fraction; --count 4096 is the whole gas.
   Hard bodies have no time scale. Therefore --hold doubles all energies whenever half is lost, and
   scales time and temperature back: a step is as accurate in a cold gas as in a hot one.

   build:  cc -O3 -march=native -std=c99 examples/ellipsoids.c dem.c -o build/ellipsoids -lm
   run:    build/ellipsoids, build/ellipsoids --quick, --xi 2 --restitution 0.9 --count 4096,
           --all (hours), --theory (no gas), --direct, --speeds (Table 2), --help

   Theory, by quadrature over isotropic orientations of two bodies that touch at a normal n. Support
   h = sqrt(n.Mn), M = R diag(b2, b2, a2) R^T; the contact point is at Mn/h; the curvature of h is
   A = M/h - (Mn)(Mn)^T/h^3 across n; the density of contacts is det(A1 + A2). With x = n.axis, in
   the frame of axis and n: A = diag(a2 b2/h^3, b2/h), D = (m/2I)(g1^2/h1^2 + g2^2/h2^2) with
   g = (a2 - b2) x sqrt(1 - x^2). Rotation reduces the effective mass of a collision by 1 + D. The mean
   over the angle between the two frames is exact: det -> p1 q1 + p2 q2 + (p1 + q1)(p2 + q2)/2.
     S_c = 4 pi <det>, area of the surface of centres at contact (spheres: 4 pi d^2)
     <D>_c, <sqrt(1 + D)>_c: means over contacts. [RUB15] (28) calls the second one <D>_c: only then
     its rate is that of spheres at xi = 1
     a body's collisions: n g S_c <sqrt(1 + D theta)>_c sqrt(T_tr/(pi m)) a second, theta =
     T_rot/T_tr; each changes the energy of translation by
     -2(1+e) T_tr/(1+D) + (1+e)^2 (T_tr + D T_rot)/(1+D)^2, that of rotation likewise; both taken
     together give theta and the cooling rate of the homogeneous state,
     zeta* = -(d ln T_tr/dt)/(n g S_c sqrt(T_tr/(pi m)))
     alpha = R S/(3V): R = <h>, and S from S_c = 2 S + 8 pi R2. (29a) gives this S; (29b) gives this
     R once its xi before the logarithm is squared
     g: [SON90], whose fourth virial coefficient is set to 18, so that spheres have Carnahan and
     Starling's (1 - phi/2)/(1 - phi)^3
   The theory assumes Gaussian velocities and spins that are not correlated; its error is about 1 %.

   Results of a case, such as xi2.00.e0.90.T_ratio:
     T_ratio, T_ratio_error   T_tr/T_rot when it no longer drifts; standard error from 8
                              blocks, increased if these are shorter than its correlation
     zeta_star, _error        cooling rate over the same time
     T_ratio_theory, zeta_star_theory
     haff_tr_rms              the same as haff_rms for T_tr
     power                    slope of ln(T_tr) against ln(t) over the last two thirds of the time
     clustering               variance over mean of the bodies in a cell of 8 on average, at the end
     heavy_ratio              --spread: temperature of bodies heavier than the mean over that of the others, at the end
     haff_rms                 root mean square of ln(T_tot/T_haff), T_haff = T(0)/(1 + tau)^2, tau =
                              alpha Gamma_0 t, alpha = (1 - e^2)/10 (spheres: 6), Gamma_0 of (28)
     mean_field_rms           the same for ln(T_tr) against the theory integrated from the start
     cooled_to, tau_end       T_tot at the end over the first; tau there
     kurtosis                 <c^4>/3 - 1 of one component, c over its root mean square: 0: Gaussian
     overlap_max              of the run, over the radius dem.h takes
     run_in_drift             energy gained in the run-in, relative
     contact_share            duration of a collision over the time between two, at the start
   [RUB15] Rubio-Largo, Lind, Maza & Hidalgo (2015); [SON90] Song & Mason, Phys. Rev. A 41 (1990) 3121, eq 25. */
#include "../dem.h"
#include "study.h"
#include "study_replay.h"

#define PI 3.14159265358979323846
#define DENSITY 2000.0      /* kg/m3 */
#define STIFFNESS 1e8       /* N/m */
#define CUBE 2.0            /* m, of 4096 bodies */
enum { NODES = 96, BLOCKS = 8, BINS = 60, CASES = 40, ELONGATIONS = 10, RESTITUTIONS = 3 };

/* in the order of dem_integrator and dem_rotation */
#define INTEGRATORS "verlet|euler|symplectic|position|leapfrog"
#define ROTATIONS "spiral|fincham|squish"

static const double elongations[ELONGATIONS] = {1, 1.15, 1.25, 1.5, 1.75, 2, 2.25, 2.5, 2.82, 3};
static const double restitutions[RESTITUTIONS] = {0.9, 0.95, 0.98};

static struct gas_options {
    double xi, restitution, fraction, overlap, collisions, run_in, dt, seconds, spread;
    const char *damping, *hold, *integrator, *rotation, *values, *out;
    int count, seed, repeats, threads, slabs, quick, brief, all, theory, direct, speeds, integrators, sizes, contact, replay;
} options = {0, 0, 0.058, 0.003, 40, 8, 0, 3, 0, "exact", "true", "verlet", "spiral", "", "build/out/ellipsoids",
             512, 1, 3, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};

static const study_option table[] = {
    {"xi", STUDY_REAL, &options.xi, 0, 10, "", "elongation; 1: spheres; 0: 1, 1.5, 2, 3"},
    {"values", STUDY_TEXT, &options.values, 0, 0, "", "elongations, such as 1.2,2.4, instead of those of --xi or --all"},
    {"restitution", STUDY_REAL, &options.restitution, 0, 1, "", "0: 0.9"},
    {"fraction", STUDY_REAL, &options.fraction, 0.001, 0.1, "of the volume", "taken up by bodies"},
    {"count", STUDY_INT, &options.count, 27, 262144, "", "of bodies, made a cube"},
    {"overlap", STUDY_REAL, &options.overlap, 1e-5, 0.1, "of the radius",
        "of a typical first collision"},
    {"collisions", STUDY_REAL, &options.collisions, 0, 1e5, "a body", "measured, about"},
    {"run-in", STUDY_REAL, &options.run_in, 0, 1e5, "collisions a body", "without damping"},
    {"dt", STUDY_REAL, &options.dt, 0, 1, "s", "time step; 0: t_c/50"},
    {"damping", STUDY_CHOICE, &options.damping, 0, 0, "exact|reduced",
        "exact: restitution is as set; reduced: gamma_n of the reduced mass"},
    {"hold", STUDY_CHOICE, &options.hold, 0, 0, "true|false", "double energies as half is lost"},
    {"integrator", STUDY_CHOICE, &options.integrator, 0, 0, INTEGRATORS, "scheme of translation"},
    {"rotation", STUDY_CHOICE, &options.rotation, 0, 0, ROTATIONS, "scheme of rotation; fincham: of [RUB15]"},
    {"spread", STUDY_REAL, &options.spread, 0, 0.9, "",
        "largest relative deviation from the mean length: bodies of one shape and several sizes"},
    {"repeats", STUDY_INT, &options.repeats, 1, 20, "", "integrators, sizes: runs of each, with the seeds that follow"},
    {"slabs", STUDY_INT, &options.slabs, 0, 64, "", "speeds: of one world, in one process; 0: no slabs"},
    {"integrators", STUDY_FLAG, &options.integrators, 0, 0, "", "drift of the energy and cooling with each scheme"},
    {"contact", STUDY_FLAG, &options.contact, 0, 0, "", "time of the quartic of [RUB15] beside that of the contact function"},
    {"sizes", STUDY_FLAG, &options.sizes, 0, 0, "", "cooling of gases of several sizes"},
    {"seed", STUDY_INT, &options.seed, 1, 1e9, "", "of the random start"},
    {"threads", STUDY_INT, &options.threads, 0, 64, "", "0: as many as there are"},
    {"out", STUDY_TEXT, &options.out, 0, 0, "", "folder for results"},
    {"quick", STUDY_FLAG, &options.quick, 0, 0, "", "one case, of fewer collisions"},
    {"short", STUDY_FLAG, &options.brief, 0, 0, "", STUDY_SHORT},
    {"replay", STUDY_FLAG, &options.replay, 0, 0, "", "write a replay of the first case, replay.html"},
    {"all", STUDY_FLAG, &options.all, 0, 0, "", "Table 1's elongations at .90, .95, .98"},
    {"theory", STUDY_FLAG, &options.theory, 0, 0, "", "S_c, <D>_c, theta, zeta*, and no gas"},
    {"direct", STUDY_FLAG, &options.direct, 0, 0, "", "the theory by drawing collisions, no gas"},
    {"speeds", STUDY_FLAG, &options.speeds, 0, 0, "", "Table 2: 64 to 262144 bodies"},
    {"seconds", STUDY_REAL, &options.seconds, 0.1, 1000, "s", "speeds: for each size"},
};

static int is(const char *a, const char *b) { return !strcmp(a, b); }
static int is_sphere(double xi) { return xi < 1 + 1e-9 && xi > 1 - 1e-9; }

static int refused(dem_world *world, dem_result result) {
    if (result != DEM_OK) study_fail("%s", dem_world_error_get(world));
    return result != DEM_OK;
}

static int place_of(const char *word, const char *list) { /* index of a word in "one|another", which contains it */
    int place = 0;
    const char *at = strstr(list, word);
    while (at > list) place += *--at == '|';
    return place;
}

/* ---- theory: lengths in units of b ---- */

typedef struct theory {
    double xi, area, d_mean, d_root;          /* S_c/b2, <D>_c, <sqrt(1 + D)>_c */
    double alpha;                             /* R S/(3V), 1 for spheres */
    double weight[NODES], p[NODES], q[NODES], d[NODES]; /* at x = n.axis: principal parts of A; D */
} theory;

/* Gauss and Legendre's points and weights on 0..1, by Newton's iteration. */
static void gauss(int n, double *x, double *w) {
    int i, j, k;
    for (i = 0; i < n; i++) {
        double z = cos(PI*(i + 0.75)/(n + 0.5)), slope = 1;
        for (k = 0; k < 8; k++) {
            double p = 1, before = 0;
            for (j = 1; j <= n; j++) {
                const double older = before;
                before = p;
                p = ((2*j - 1)*z*p - (j - 1)*older)/j;
            }
            slope = n*(z*p - before)/(z*z - 1);
            z -= p/slope;
        }
        x[i] = (1 - z)/2;
        w[i] = 1/((1 - z*z)*slope*slope);
    }
}

static double det_mean(const theory *t, int i, int j) {
    return t->p[i]*t->q[i] + t->p[j]*t->q[j] + (t->p[i] + t->q[i])*(t->p[j] + t->q[j])/2;
}

static void theory_make(double xi, theory *t) {
    double x[NODES], sum = 0, d = 0, root = 0, radius = 0, surface;
    int i, j;
    memset(t, 0, sizeof *t);
    t->xi = xi;
    gauss(NODES, x, t->weight);
    for (i = 0; i < NODES; i++) {
        const double h2 = 1 + (xi*xi - 1)*x[i]*x[i], h = sqrt(h2);
        const double g = (xi*xi - 1)*x[i]*sqrt(1 - x[i]*x[i]);
        t->p[i] = xi*xi/(h2*h);
        t->q[i] = 1/h;
        t->d[i] = 5/(1 + xi*xi)/2*g*g/h2;     /* I = m (a2 + b2)/5 */
        radius += t->weight[i]*h;
    }
    for (i = 0; i < NODES; i++)
        for (j = 0; j < NODES; j++) {
            const double w = t->weight[i]*t->weight[j]*det_mean(t, i, j), both = t->d[i] + t->d[j];
            sum += w;
            d += w*both;
            root += w*sqrt(1 + both);
        }
    t->area = 4*PI*sum;
    t->d_mean = d/sum;
    t->d_root = root/sum;
    surface = (t->area - 8*PI*radius*radius)/2;
    t->alpha = radius*surface/(4*PI*xi);
}

/* Returns the restitution under the damping of [RUB15], which is that of e for the reduced mass, at a contact whose mass
   is smaller by 1 + D. */
static double restitution_at(double e, double d, int reduced_damping) {
    const double l = log(e), beta = -l/sqrt(PI*PI + l*l)*sqrt(1 + d);
    if (!reduced_damping) return e;
    return beta < 1 ? exp(-PI*beta/sqrt(1 - beta*beta)) : 0;
}

/* -d ln T_tr/ds and -d ln T_rot/ds, ds = n g S_c sqrt(T_tr/(pi m)) dt */
static void theory_rates(const theory *t, double theta, double e, int reduced_damping,
                         double *translation, double *rotation) {
    double sum = 0, tr = 0, rot = 0;
    int i, j;
    for (i = 0; i < NODES; i++)
        for (j = 0; j < NODES; j++) {
            const double w = t->weight[i]*t->weight[j]*det_mean(t, i, j), d = t->d[i] + t->d[j];
            const double a = 1 + restitution_at(e, d, reduced_damping), total = 1 + d*theta;
            const double often = w*sqrt(total), back = a*a*total/((1 + d)*(1 + d));
            sum += w;
            tr += often*(back - 2*a/(1 + d));
            rot += often*d*(back - 2*a*theta/(1 + d));
        }
    *translation = -tr/sum/3;
    *rotation = -rot/sum/2/theta;
}

/* Finds the stationary theta = T_rot/T_tr and the rate at which both then fall. Spheres: 1. */
static void theory_state(const theory *t, double e, int reduced_damping, double *theta, double *zeta) {
    double lo = 0.01, hi = 1000, rotation;
    int i;
    *theta = 1;
    for (i = 0; i < 50 && t->d_mean > 1e-9; i++) {
        *theta = sqrt(lo*hi);
        theory_rates(t, *theta, e, reduced_damping, zeta, &rotation);
        if (rotation > *zeta) hi = *theta;
        else lo = *theta;
    }
    theory_rates(t, *theta, e, reduced_damping, zeta, &rotation);
    if (t->d_mean > 1e-9) return;
    { /* spheres: first Sonine polynomial, (1 + 3 a2/16) */
        const double a2 = 16*(1 - e)*(1 - 2*e*e)/(81 - 17*e + 30*e*e*(1 - e));
        *zeta *= 1 + 3*a2/16;
    }
}

/* Contact value of the pair distribution, Z = 1 + (1 + 3 alpha) phi g. */
static double contact_value(double alpha, double phi) {
    const double b4 = 18;                     /* exact: 18.365; at .058 g differs by 3e-4 */
    return (1 + 3*alpha - (2 + 3*alpha - 3*alpha*alpha)*phi +
            (1 + (b4 - 12)*alpha - 7*alpha*alpha)*phi*phi)/((1 + 3*alpha)*pow(1 - phi, 3));
}

/* ---- one gas ---- */

typedef struct sample { double time, s, tr, rot; } sample;     /* s; 1; J, J */
typedef struct gas {
    double xi, e, cube, mass, a, b, radius, inertia, contact_time, dt;
    double rate;                              /* ds/dt over the root of T_tr */
    int count, side, spheres;
    theory t;
    dem_world *world;
    dem_material material;
    double scale, time, s;                    /* factor by which speeds are too high; s; 1 */
    uint64_t random, steps;
    int sample_count, sample_room;
    sample *samples;
    double histogram[3][BINS], histogram_sum[3], fourth, fourth_sum;
    double ratio, zeta, ratio_theory, zeta_theory, tau_rate, drift, heavy, largest;
    study_replay replay;
} gas;

static double uniform(gas *g) { /* 0 < u < 1, splitmix64 */
    uint64_t z = (g->random += UINT64_C(0x9E3779B97F4A7C15));
    z = (z ^ (z >> 30))*UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27))*UINT64_C(0x94D049BB133111EB);
    return ((double)((z ^ (z >> 31)) >> 11) + 0.5)/9007199254740992.0;
}
static double normal(gas *g) {
    const double r = sqrt(-2*log(uniform(g)));
    return r*cos(2*PI*uniform(g));
}

static void gas_destroy(gas *g) {
    dem_world_destroy(g->world);
    g->world = 0;
    free(g->samples);
    g->samples = 0;
}

/* The damping of [RUB15]: gamma = sqrt(4 k m12/(1 + (pi/ln e)^2)), for any inertia. */
static double seed_gamma;                     /* N s/m; 0 while running in */
static void seed_law(const dem_contact *c, dem_real *memory, dem_contact_force *force) {
    (void)memory;
    force->normal = c->kn*c->overlap + *(const double *)c->user*c->closing_speed;
}

/* Sizes, temperature and world; e = 1 until the run-in is over. */
static int gas_create(gas *g, double xi, double e, int count) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = DEM_MATERIAL_DESC;
    double volume;
    int i;
    memset(g, 0, sizeof *g);
    g->xi = xi;
    g->e = e;
    g->spheres = is_sphere(xi);
    g->side = (int)(cbrt(count) + 0.5);
    g->count = g->side*g->side*g->side;
    g->cube = CUBE*cbrt(g->count/4096.0);
    volume = options.fraction*g->cube*g->cube*g->cube/g->count;
    g->radius = cbrt(volume*3/(4*PI));
    g->b = g->radius/cbrt(xi);
    g->a = xi*g->b;
    g->mass = DENSITY*volume;
    g->inertia = g->mass*(g->a*g->a + g->b*g->b)/5;
    g->contact_time = PI*sqrt(g->mass/2/STIFFNESS);
    if (options.spread > 0)                     /* of the lightest bodies */
        g->contact_time *= pow((1 - options.spread)/cbrt(1 + options.spread*options.spread), 1.5);
    g->dt = options.dt > 0 ? options.dt : g->contact_time/50;
    theory_make(xi, &g->t);
    g->rate = contact_value(g->t.alpha, options.fraction)*g->t.area*g->b*g->b*g->count/
              pow(g->cube, 3)/sqrt(PI*g->mass);
    g->scale = 1;
    g->random = (uint64_t)options.seed;
    desc.domain = dem_box_make(0, 0, 0, g->cube, g->cube, g->cube);
    for (i = 0; i < 3; i++) desc.boundary[i] = DEM_BOUNDARY_PERIODIC;
    desc.normal_law = DEM_NORMAL_LINEAR;
    desc.threads = options.threads;
    desc.dt = g->dt;
    desc.integrator = (dem_integrator)place_of(options.integrator, INTEGRATORS);
    desc.rotation = (dem_rotation)place_of(options.rotation, ROTATIONS);
    if (is(options.damping, "reduced")) {
        desc.law = seed_law;
        desc.law_user = &seed_gamma;
        desc.law_stiffness = STIFFNESS;
        desc.ellipsoid_overlap = DEM_OVERLAP_CHORD;
    }
    seed_gamma = 0;
    g->world = dem_world_create(&desc);
    if (!g->world) { study_fail("%s", dem_world_create_error_get(&desc)); return 1; }
    stuff.density = DENSITY;
    stuff.stiffness = STIFFNESS;
    stuff.restitution = 1;
    g->material = dem_material_add(g->world, &stuff);
    return g->material.id ? 0 : refused(g->world, DEM_ERROR_ARGUMENT);
}

/* Places the bodies on a simple cubic lattice or at random. They are at random for --speeds, so that
   collisions begin at the first step, and where a lattice has no room for all orientations.
   Orientations are random; velocities, and spins across the axis, have one temperature (J). */
static int gas_fill(gas *g, double temperature, int anywhere) {
    const size_t n = (size_t)g->count;
    const double pitch = g->cube/g->side, speed = sqrt(temperature/g->mass);
    const double spin = sqrt(temperature/g->inertia);
    dem_real *at = (dem_real *)study_alloc(3*n, sizeof *at);
    dem_real *turned = (dem_real *)study_alloc(4*n, sizeof *turned);
    dem_real *v = (dem_real *)study_alloc(3*n, sizeof *v);
    dem_real *w = (dem_real *)study_alloc(3*n, sizeof *w);
    dem_real *size = (dem_real *)study_alloc(n, sizeof *size);
    double mean[3] = {0, 0, 0}, energy = 0, turning = 0, cubes = 0;
    dem_shape shape;
    int i, k, bad = 0;
    shape.id = 0;
    for (i = 0; i < g->count; i++) {   /* with the volume of bodies of one size in all */
        size[i] = options.spread > 0 ? 1 + options.spread*(2*uniform(g) - 1) : 1;
        cubes += pow(size[i], 3)/g->count;
    }
    for (i = 0; i < g->count; i++) {
        size[i] /= cbrt(cubes);
        g->largest = fmax(g->largest, size[i]);
    }
    for (i = 0; i < g->count; i++) {
        const double heavy = pow(size[i], 1.5), inert = pow(size[i], 2.5);   /* roots of mass and moment over the mean's */
        dem_quat q;
        dem_vec3 across;
        double l = 0, four[4];
        for (k = 0; k < 3; k++) {
            const int cell = k == 0 ? i%g->side : k == 1 ? i/g->side%g->side : i/g->side/g->side;
            at[3*i + k] = pitch*(cell + 0.5);
            v[3*i + k] = speed*normal(g)/heavy;
            mean[k] += v[3*i + k]*pow(size[i], 3)/g->count;
        }
        for (k = 0; k < 4; k++) { four[k] = normal(g); l += four[k]*four[k]; }
        for (k = 0; k < 4; k++) turned[4*i + k] = four[k]/sqrt(l);
        q = dem_quat_make(turned[4*i], turned[4*i + 1], turned[4*i + 2], turned[4*i + 3]);
        across.x = spin*normal(g)/inert;
        across.y = spin*normal(g)/inert;
        across.z = 0;
        across = dem_quat_rotate(q, across);
        w[3*i] = across.x; w[3*i + 1] = across.y; w[3*i + 2] = across.z;
    }
    for (i = 0; i < 3*g->count; i++) {
        v[i] -= mean[i%3];
        energy += g->mass*pow(size[i/3], 3)*v[i]*v[i]/2;
        turning += g->inertia*pow(size[i/3], 5)*w[i]*w[i]/2;
    }
    for (i = 0; i < 3*g->count; i++) { /* sets exactly the given temperature */
        v[i] *= sqrt(1.5*(g->count - 1)*temperature/energy);
        w[i] *= sqrt(g->count*temperature/turning);
    }
    if (!g->spheres) {
        shape = dem_shape_ellipsoid_add(g->world, dem_vec3_make(g->b, g->b, g->a));
        bad = !shape.id && refused(g->world, DEM_ERROR_ARGUMENT);
    }
    if (options.spread > 0 && (g->spheres || anywhere || 2*g->a*g->largest > 1.001*pitch)) {
        study_fail("--spread %g needs ellipsoids on a lattice: xi above 1 and axes up to %g m, below the pitch of %g m; lower "
                   "--xi, --spread or --fraction", options.spread, 2*g->a*g->largest, pitch);
        bad = 1;
    } else if (!bad && (anywhere || 2*g->a > 1.001*pitch)) { /* then speeds in the order they stand in */
        const dem_box box = dem_box_make(0, 0, 0, g->cube, g->cube, g->cube);
        const int placed = g->spheres
            ? dem_spheres_fill(g->world, g->material, g->radius, dem_region_make(box), g->count,
                               1)
            : dem_bodies_fill(g->world, g->material, shape, dem_region_make(box), g->count, 1);
        bad = placed < g->count && refused(g->world, DEM_ERROR_ARGUMENT);
        for (i = 0; !bad && i < g->count; i++) {
            dem_body_state s;
            const dem_body id = dem_body_id_get(g->world, i);
            dem_body_get(g->world, id, &s);
            s.velocity = dem_vec3_make(v[3*i], v[3*i + 1], v[3*i + 2]);
            if (!g->spheres) s.spin = dem_quat_rotate(s.orientation, dem_quat_unrotate(
                dem_quat_make(turned[4*i], turned[4*i + 1], turned[4*i + 2], turned[4*i + 3]),
                dem_vec3_make(w[3*i], w[3*i + 1], w[3*i + 2])));
            bad = refused(g->world, dem_body_set(g->world, id, &s));
        }
    } else if (!bad && g->spheres) {
        bad = refused(g->world, dem_spheres_add(g->world, g->material, g->count, at, v, 0,
                                                g->radius));
    } else if (!bad) {
        bad = refused(g->world, dem_bodies_add(g->world, g->material, shape, g->count, at, turned,
                                               v, w, options.spread > 0 ? size : 0));
    }
    free(at); free(turned); free(v); free(w); free(size);
    if (!bad) dem_world_check_print(g->world, stderr);
    return bad;
}

/* Returns the temperatures (J) of the gas without the factor `scale`. */
static sample gas_look(const gas *g) {
    const dem_totals totals = dem_totals_get(g->world);
    sample now;
    now.time = g->time;
    now.s = g->s;
    now.tr = totals.kinetic/(1.5*(g->count - 1))/(g->scale*g->scale);
    now.rot = g->spheres ? 0 : totals.rotational/g->count/(g->scale*g->scale);
    return now;
}
/* Returns the temperature of the heavier half of the bodies over that of the others. */
static double heavy_ratio(const gas *g) {
    const dem_bodies b = dem_bodies_get(g->world);
    double mean = 0, energy[2] = {0, 0}, count[2] = {0, 0};
    int i, k;
    for (i = 0; i < b.count; i++) mean += b.masses[i]/b.count;
    for (i = 0; i < b.count; i++) {
        const int heavy = b.masses[i] > mean;
        for (k = 0; k < 3; k++) energy[heavy] += b.masses[i]*b.velocities[4*i + k]*b.velocities[4*i + k];
        count[heavy]++;
    }
    return energy[1]/count[1]/(energy[0]/count[0]);
}
/* Returns the variance of the number of bodies in cells of 8 on average, over the mean: 1 for points without correlation,
   less for bodies that exclude each other, more for clusters. */
static double clustering(const gas *g) {
    const dem_bodies b = dem_bodies_get(g->world);
    const int side = g->side/2 > 0 ? g->side/2 : 1, cells = side*side*side;
    int *count = (int *)study_alloc((size_t)cells, sizeof *count), i, k;
    double sum = 0;
    for (i = 0; i < b.count; i++) {
        int cell = 0;
        for (k = 0; k < 3; k++) {
            const double x = b.positions[4*i + k]/g->cube;
            const int at = (int)((x - floor(x))*side);
            cell = cell*side + (at < side ? at : side - 1);
        }
        count[cell]++;
    }
    for (i = 0; i < cells; i++) sum += pow(count[i] - (double)b.count/cells, 2);
    free(count);
    return sum/b.count;
}
static double energy_of(const gas *g, const sample *a) {
    return 1.5*(g->count - 1)*a->tr + g->count*a->rot;
}

static int gas_scale(gas *g, double by) {
    int i;
    for (i = 0; i < g->count; i++) {
        dem_body_state s;
        const dem_body id = dem_body_id_get(g->world, i);
        dem_body_get(g->world, id, &s);
        s.velocity = dem_vec3_make(by*s.velocity.x, by*s.velocity.y, by*s.velocity.z);
        s.spin = dem_vec3_make(by*s.spin.x, by*s.spin.y, by*s.spin.z);
        if (refused(g->world, dem_body_set(g->world, id, &s))) return 1;
    }
    g->scale *= by;
    return 0;
}

static double work(const gas *g, uint64_t since) {
    return (double)(g->steps - since)*g->count;
}

/* For `span` in units of s; keeps samples a tenth of a unit apart. window 0: keeps none; else where
   the histogram of velocities goes. */
static int gas_run(gas *g, const char *what, double span, int window) {
    const double from = g->s;
    const uint64_t begun = g->steps;
    double first;
    sample now = gas_look(g);
    first = energy_of(g, &now)*g->scale*g->scale;
    study_progress(what, 0, 0);
    while (g->s < from + span) {
        const double quick = g->rate*sqrt(now.tr)*g->scale*g->dt;       /* s per step */
        const int steps = quick < 0.1 ? (int)ceil(0.1/quick) : 1;
        const double before = now.tr;
        dem_bodies b;
        int i, k;
        if (refused(g->world, dem_world_step(g->world, steps))) return 1;
        g->steps += (uint64_t)steps;
        g->time += steps*g->dt*g->scale;
        now = gas_look(g);
        g->s += g->rate*(sqrt(before) + sqrt(now.tr))/2*steps*g->dt*g->scale;
        now.time = g->time;
        now.s = g->s;
        study_progress(what, fmin((g->s - from)/span, 1), work(g, begun));
        if (g->s >= g->replay.taken*g->replay.interval) {      /* without a replay: nothing */
            study_replay_value(&g->replay, "log10 of T_tr (J)", log10(now.tr));
            study_replay_value(&g->replay, "T_rot over T_tr", now.rot/now.tr);
            study_replay_frame(&g->replay);
        }
        if (g->sample_count == g->sample_room) {
            sample *more;
            g->sample_room = 2*g->sample_room + 256;
            more = (sample *)study_alloc((size_t)g->sample_room, sizeof *more);
            if (g->sample_count) memcpy(more, g->samples, (size_t)g->sample_count*sizeof *more);
            free(g->samples);
            g->samples = more;
        }
        if (window) g->samples[g->sample_count++] = now;
        b = dem_bodies_get(g->world);
        for (i = 0; window && i < b.count; i++)
            for (k = 0; k < 3; k++) {
                const double c = b.velocities[4*i + k]/g->scale/sqrt(now.tr/b.masses[i]);
                const int bin = (int)floor((c + 6)*BINS/12);
                if (bin >= 0 && bin < BINS) g->histogram[window - 1][bin]++;
                g->histogram_sum[window - 1]++;
                if (window > 1) { g->fourth += c*c*c*c; g->fourth_sum++; }
            }
        if (window && is(options.hold, "true") && energy_of(g, &now)*g->scale*g->scale < first/2 &&
            gas_scale(g, sqrt(2.0))) return 1;
    }
    study_progress(what, 1, work(g, begun));
    return 0;
}

/* Returns the time, in s, after which theta is within 1 % of its stationary value, from T_rot = T_tr
   on, by the theory. */
static double settling(const gas *g, int reduced_damping, double theta_end) {
    double theta = 1, s = 0, translation, rotation;
    const double step = 0.05;
    while (fabs(log(theta/theta_end)) > 0.01 && s < 1000) {
        double middle;
        theory_rates(&g->t, theta, g->e, reduced_damping, &translation, &rotation);
        middle = theta*exp((translation - rotation)*step/2);
        theory_rates(&g->t, middle, g->e, reduced_damping, &translation, &rotation);
        theta *= exp((translation - rotation)*step);
        s += step;
    }
    return s;
}

/* Returns the correlation time of T_rot/T_tr, in s: near xi = 1 several collisions per body. */
static double relaxation(const theory *t, double theta, double e, int reduced_damping) {
    const double step = 0.01;
    double tr[2], rot[2];
    int k;
    for (k = 0; k < 2; k++)
        theory_rates(t, theta*exp(k*step), e, reduced_damping, &tr[k], &rot[k]);
    return step/(rot[1] - rot[0] - tr[1] + tr[0]);
}

static void tell(const gas *g, const char *what, double value, const char *unit) {
    char name[64];
    snprintf(name, sizeof name, "xi%.2f.e%.2f.%s", g->xi, g->e, what);
    study_result(name, value, unit);
}

/* Computes ratio and cooling rate over the samples from `from` on, in blocks of equal s. Blocks that
   are not longer than the correlation time r of T_rot/T_tr are correlated: neighbours by
   c = exp(-block/r). The error of the mean is then sqrt((1 + c)/(1 - c)) times that of independent
   blocks. */
static void gas_measure(gas *g, int from, int reduced_damping) {
    double ratio[BLOCKS], zeta[BLOCKS], mean[2] = {0, 0}, spread[2] = {0, 0};
    const double s0 = g->samples[from].s, s1 = g->samples[g->sample_count - 1].s;
    const double memory = g->spheres ? 0 : exp(-(s1 - s0)/BLOCKS/
        relaxation(&g->t, 1/g->ratio_theory, g->e, reduced_damping));
    const double wider = sqrt((1 + memory)/(1 - memory));
    int block, i = from, first = from;
    for (block = 0; block < BLOCKS; block++) {
        const double end = s0 + (s1 - s0)*(block + 1)/BLOCKS;
        const sample *a = &g->samples[first], *z;
        double sum = 0, weight = 0;
        while (i + 1 < g->sample_count && g->samples[i].s < end - 1e-9*end) {
            const double ds = g->samples[i + 1].s - g->samples[i].s;
            sum += ds*(g->spheres ? 0 : log(g->samples[i].tr/g->samples[i].rot));
            weight += ds;
            i++;
        }
        z = &g->samples[i];
        ratio[block] = exp(sum/weight);
        zeta[block] = -log(energy_of(g, z)/energy_of(g, a))/(z->s - a->s);
        mean[0] += ratio[block]/BLOCKS;
        mean[1] += zeta[block]/BLOCKS;
        first = i;
    }
    for (block = 0; block < BLOCKS; block++) {
        spread[0] += pow(ratio[block] - mean[0], 2)/(BLOCKS*(BLOCKS - 1));
        spread[1] += pow(zeta[block] - mean[1], 2)/(BLOCKS*(BLOCKS - 1));
    }
    g->ratio = mean[0];
    g->zeta = -log(energy_of(g, &g->samples[g->sample_count - 1])/energy_of(g, &g->samples[from]))/
              (s1 - s0);
    if (!g->spheres) {
        tell(g, "T_ratio", g->ratio, "");
        tell(g, "T_ratio_error", wider*sqrt(spread[0]), "");
        tell(g, "T_ratio_theory", g->ratio_theory, "");
    }
    tell(g, "zeta_star", g->zeta, "");
    tell(g, "zeta_star_error", wider*sqrt(spread[1]), "");
    tell(g, "zeta_star_theory", g->zeta_theory, "");
}

/* Compares the samples with Haff's law as in [RUB15], and with the integrated theory. */
static double total_of(const gas *g, const sample *a) { /* (26); spheres: T_tr */
    return g->spheres ? a->tr : 0.6*a->tr + 0.4*a->rot;
}
static void gas_compare(gas *g, int reduced_damping) {
    const double total = total_of(g, &g->samples[0]);
    const sample *last = &g->samples[g->sample_count - 1], *middle = last;
    double haff = 0, haff_tr = 0, course = 0, theta = g->samples[0].rot/g->samples[0].tr;
    double log_tr = log(g->samples[0].tr), translation, rotation;
    int i;
    g->tau_rate = (1 - g->e*g->e)/(g->spheres ? 6 : 10)*g->rate*g->t.d_root*sqrt(total);
    if (g->spheres) theta = 1;
    for (i = 1; i < g->sample_count; i++) {
        const sample *a = &g->samples[i];
        const double ds = a->s - g->samples[i - 1].s;
        const double tau = g->tau_rate*(a->time - g->samples[0].time);
        theory_rates(&g->t, theta, g->e, reduced_damping, &translation, &rotation);
        log_tr -= translation*ds;
        if (!g->spheres) theta *= exp((translation - rotation)*ds);
        course += pow(log(a->tr) - log_tr, 2);
        haff += pow(log(total_of(g, a)/total*(1 + tau)*(1 + tau)), 2);
        haff_tr += pow(log(a->tr/g->samples[0].tr*(1 + tau)*(1 + tau)), 2);
    }
    while (middle > g->samples && 3*(middle->time - g->samples[0].time) > last->time - g->samples[0].time) middle--;
    tell(g, "haff_rms", sqrt(haff/(g->sample_count - 1)), "");
    tell(g, "haff_tr_rms", sqrt(haff_tr/(g->sample_count - 1)), "");
    tell(g, "power", log(last->tr/middle->tr)/log((last->time - g->samples[0].time)/(middle->time - g->samples[0].time)), "");
    tell(g, "mean_field_rms", sqrt(course/(g->sample_count - 1)), "");
    tell(g, "cooled_to", total_of(g, &g->samples[g->sample_count - 1])/total, "of the first");
    tell(g, "tau_end", g->tau_rate*(g->time - g->samples[0].time), "");
}

static int gas_case(gas *g, double xi, double e) {
    const int reduced_damping = is(options.damping, "reduced");
    const double speed = options.overlap/2; /* over radius/sqrt(m12/k): <v_n2> = 4 T/m */
    double theta, zeta, wait, start, temperature;
    char what[64], name[64];
    dem_pair pair;
    int i, from = 0;
    if (gas_create(g, xi, e, options.count)) return 1;
    theory_state(&g->t, e, reduced_damping, &theta, &zeta);
    g->ratio_theory = 1/theta;
    g->zeta_theory = zeta;
    temperature = g->mass*pow(speed*g->radius, 2)/(g->mass/2/STIFFNESS);
    if (gas_fill(g, temperature, 0)) return 1;
    wait = options.brief ? 0.5 : g->spheres ? 2 : settling(g, reduced_damping, theta) + 2;
    snprintf(what, sizeof what, "xi %.2f e %.2f run-in", xi, e);
    start = dem_totals_get(g->world).kinetic + dem_totals_get(g->world).rotational;
    if (options.run_in > 0 && gas_run(g, what, options.run_in/g->t.d_root, 0)) return 1;
    g->drift = (dem_totals_get(g->world).kinetic + dem_totals_get(g->world).rotational)/start - 1;
    tell(g, "run_in_drift", g->drift, "");
    if (refused(g->world, dem_pair_get(g->world, g->material, g->material, &pair))) return 1;
    pair.restitution = e;
    seed_gamma = sqrt(4*STIFFNESS*g->mass/2/(1 + pow(PI/log(e), 2)));
    if (refused(g->world, dem_pair_set(g->world, g->material, g->material, &pair))) return 1;
    g->time = g->s = 0;
    g->steps = 0;
    g->samples = (sample *)study_alloc(256, sizeof *g->samples);
    g->sample_room = 256;
    g->samples[g->sample_count++] = gas_look(g);
    g->replay = study_replay_open(g->world, options.replay ? 200 : 0, wait + options.collisions/g->t.d_root,
                        "A granular gas of ellipsoids that cools: energies are doubled whenever half is lost");
    options.replay = 0;                         /* the first case */
    snprintf(what, sizeof what, "xi %.2f e %.2f settling", xi, e);
    if (gas_run(g, what, wait, 1)) return 1;
    from = g->sample_count - 1;
    snprintf(what, sizeof what, "xi %.2f e %.2f measuring", xi, e);
    for (i = 0; i < 2; i++) {
        snprintf(what, sizeof what, "xi %.2f e %.2f half %d", xi, e, i + 1);
        if (gas_run(g, what, options.collisions/g->t.d_root/2, 2 + i)) return 1;
    }
    study_replay_close(&g->replay);
    gas_measure(g, from, reduced_damping);
    gas_compare(g, reduced_damping);
    tell(g, "kurtosis", g->fourth/g->fourth_sum/3 - 1, "");
    tell(g, "clustering", clustering(g), "");
    if (options.spread > 0) tell(g, "heavy_ratio", g->heavy = heavy_ratio(g), "");
    tell(g, "overlap_max", dem_counters_get(g->world).overlap_max, "");
    tell(g, "contact_share", g->contact_time*g->rate*g->t.d_root*sqrt(temperature), "at the start");
    { /* its course */
        const int n = g->sample_count;
        double *column[5];
        for (i = 0; i < 5; i++) column[i] = (double *)study_alloc((size_t)n, sizeof(double));
        for (i = 0; i < n; i++) {
            column[0][i] = g->samples[i].time;
            column[1][i] = g->samples[i].s;
            column[2][i] = g->tau_rate*g->samples[i].time;
            column[3][i] = g->samples[i].tr;
            column[4][i] = g->samples[i].rot;
        }
        snprintf(name, sizeof name, "xi%.2f_e%.2f.csv", xi, e);
        study_csv(name, "time_s,s,tau,T_tr_J,T_rot_J", n, 5, (const double *const *)column);
        for (i = 0; i < 5; i++) free(column[i]);
    }
    dem_world_destroy(g->world);
    g->world = 0;
    return 0;
}

/* ---- the theory without its assumptions on velocities: random collisions ---- */

/* A body is a velocity, a spin and the axis across it; b = m = 1. Pairs and normals are drawn at
   random and accepted in proportion to det(A1 + A2) times the speed of approach. Between two
   collisions a body rotates about its spin by a random angle. Positions are not needed, because the
   gas is dilute and homogeneous. */
typedef struct draw { double v[3], w[3], u[3]; } draw;

static double dot3(const double *a, const double *b) { return a[0]*b[0] + a[1]*b[1] + a[2]*b[2]; }
static void cross3(const double *a, const double *b, double *c) {
    c[0] = a[1]*b[2] - a[2]*b[1];
    c[1] = a[2]*b[0] - a[0]*b[2];
    c[2] = a[0]*b[1] - a[1]*b[0];
}
static void unit3(double *a) {
    const double l = sqrt(dot3(a, a));
    int k;
    for (k = 0; k < 3; k++) a[k] /= l;
}

/* The quantities of one body in a collision with outward normal n: arm x n, p, q, and its axis across n. */
typedef struct side { double moment_arm[3], p, q, e[3], speed; } side;
static void side_of(gas *g, draw *d, const double *n, double sign, side *o) {
    const double more = g->xi*g->xi - 1, spin = sqrt(dot3(d->w, d->w));
    double turned[3], x, h, l = 0;
    int k;
    if (spin > 0) { /* moves the axis to a random point of its circle */
        const double angle = 2*PI*uniform(g), c = cos(angle), s = sin(angle)/spin;
        cross3(d->w, d->u, turned);
        for (k = 0; k < 3; k++) d->u[k] = c*d->u[k] + s*turned[k];
        unit3(d->u);
    }
    x = dot3(d->u, n);
    h = sqrt(1 + more*x*x);
    cross3(d->u, n, o->moment_arm);
    for (k = 0; k < 3; k++) {
        o->moment_arm[k] *= sign*more*x/h;              /* (M n/h) x n, M n = n + more x u */
        o->e[k] = d->u[k] - x*n[k];
        l += o->e[k]*o->e[k];
    }
    for (k = 0; k < 3; k++) o->e[k] /= sqrt(l) + 1e-300;
    o->p = g->xi*g->xi/(h*h*h);
    o->q = 1/h;
    o->speed = dot3(d->v, n) + dot3(d->w, o->moment_arm);
}

static void direct_case(double xi, double e) {
    enum { COUNT = 20000 };
    static draw bodies[COUNT];
    static gas g;
    const double inertia = (1 + xi*xi)/5, most = xi > 1 ? xi : 1/xi;  /* of a curvature */
    const int spheres = is_sphere(xi);
    double theta, zeta, s = 0, bound = 0, tr = 1, sum = 0, weight = 0, from = 0, start = 0;
    double wait, end, e_now = 0, ratio;
    int i, k, round;
    memset(&g, 0, sizeof g);
    g.xi = xi;
    g.e = e;
    g.random = (uint64_t)options.seed;
    theory_make(xi, &g.t);
    theory_state(&g.t, e, 0, &theta, &zeta);
    wait = options.brief ? 0.05 : settling(&g, 0, theta) + 2;
    end = wait + (options.brief ? 0.4 : options.collisions);
    for (i = 0; i < COUNT; i++) {
        draw *d = &bodies[i];
        double any[3];
        for (k = 0; k < 3; k++) { d->v[k] = normal(&g); d->u[k] = normal(&g); any[k] = normal(&g); }
        unit3(d->u);
        cross3(d->u, any, d->w);
        for (k = 0; k < 3; k++) d->w[k] *= spheres ? 0 : 1/sqrt(inertia); /* spheres keep spins */
    }
    g.scale = 0;                                   /* ln of what energies were divided by */
    for (round = 0; s < end; round++) {
        double kinetic = 0, turning = 0, mean[3] = {0, 0, 0}, by;
        for (i = 0; i < COUNT; i++)
            for (k = 0; k < 3; k++) mean[k] += bodies[i].v[k]/COUNT;
        for (i = 0; i < COUNT; i++)
            for (k = 0; k < 3; k++) {
                bodies[i].v[k] -= mean[k];
                kinetic += bodies[i].v[k]*bodies[i].v[k]/2;
                turning += inertia*bodies[i].w[k]*bodies[i].w[k]/2;
            }
        tr = kinetic/(1.5*COUNT);
        ratio = kinetic/1.5/turning;
        e_now = log(kinetic + turning) + g.scale;
        if (s >= wait && from <= 0) { from = s; start = e_now; }
        if (from > 0) { sum += log(ratio); weight++; }
        by = sqrt(tr);                             /* back to T_tr = 1: no units of time in it */
        g.scale += log(tr);
        for (i = 0; i < COUNT; i++)
            for (k = 0; k < 3; k++) { bodies[i].v[k] /= by; bodies[i].w[k] /= by; }
        if (round == 0 || round == 20)             /* rare excess is cut: 1e-4 of collisions */
            bound = 4*most*most*7*sqrt(1 + g.t.d_mean*theta);
        for (i = 0; i < COUNT; i++) {              /* candidates */
            draw *a = &bodies[(int)(uniform(&g)*COUNT)], *b = &bodies[(int)(uniform(&g)*COUNT)];
            double n[3], det, close, along, push;
            side A, B;
            s += g.t.area/sqrt(PI)/(COUNT*2*PI*bound);
            if (a == b) continue;
            for (k = 0; k < 3; k++) n[k] = normal(&g);
            unit3(n);
            side_of(&g, a, n, 1, &A);
            side_of(&g, b, n, -1, &B);
            /* b's outward normal is -n: its contact point is at -(M n/h), and so is its moment_arm */
            close = A.speed - (dot3(b->v, n) + dot3(b->w, B.moment_arm));
            if (close <= 0) continue;
            along = dot3(A.e, B.e);
            along *= along;
            det = A.p*A.q + B.p*B.q + (A.p*B.q + A.q*B.p)*along +
                  (A.p*B.p + A.q*B.q)*(1 - along);
            if (uniform(&g)*bound > det*close) continue;
            push = (1 + e)*close/(2 + (dot3(A.moment_arm, A.moment_arm) + dot3(B.moment_arm, B.moment_arm))/inertia);
            for (k = 0; k < 3; k++) {
                a->v[k] -= push*n[k];
                b->v[k] += push*n[k];
                a->w[k] -= push*A.moment_arm[k]/inertia;
                b->w[k] += push*B.moment_arm[k]/inertia;
            }
        }
    }
    if (!spheres) tell(&g, "T_ratio_direct", exp(sum/weight), "");
    if (!spheres) tell(&g, "T_ratio_theory", 1/theta, "");
    tell(&g, "zeta_star_direct", -(e_now - start)/(s - from), "");
    tell(&g, "zeta_star_theory", zeta, "");
}

/* ---- results ---- */

static void theory_tell(void) {
    static const double more[] = {0.5, 1, 1.15, 1.25, 1.5, 1.75, 2, 2.25, 2.5, 2.82, 3, 5};
    static const double e[] = {0.98, 0.95, 0.9, 0.8, 0.5};
    enum { ROWS = 12, RATIOS = 5, COLUMNS = 6 + 2*RATIOS };
    double data[COLUMNS][ROWS];
    const double *columns[COLUMNS];
    int i, k;
    for (k = 0; k < COLUMNS; k++) columns[k] = data[k];
    printf("%5s %9s %8s %9s %7s %7s", "xi", "S_c/b2", "<D>_c", "<rt 1+D>", "alpha", "g");
    for (k = 0; k < RATIOS; k++) printf("   theta%.2f zeta%.2f", e[k], e[k]);
    printf("\n");
    for (i = 0; i < ROWS; i++) {
        theory t;
        theory_make(more[i], &t);
        data[0][i] = t.xi;
        data[1][i] = t.area;
        data[2][i] = t.d_mean;
        data[3][i] = t.d_root;
        data[4][i] = t.alpha;
        data[5][i] = contact_value(t.alpha, options.fraction);
        printf("%5.2f %9.4f %8.5f %9.5f %7.4f %7.4f", t.xi, t.area, t.d_mean, t.d_root, t.alpha,
               data[5][i]);
        for (k = 0; k < RATIOS; k++) {
            theory_state(&t, e[k], is(options.damping, "reduced"), &data[6 + 2*k][i],
                         &data[7 + 2*k][i]);
            printf("   %9.4f %8.5f", data[6 + 2*k][i], data[7 + 2*k][i]);
        }
        printf("\n");
    }
    study_csv("theory.csv", "xi,S_c,D_mean,root_mean,alpha,g,theta0.98,zeta0.98,theta0.95,zeta0.95,"
              "theta0.90,zeta0.90,theta0.80,zeta0.80,theta0.50,zeta0.50", ROWS, COLUMNS, columns);
}

static study_figure figure(const char *title, const char *x, const char *y) {
    study_figure f;
    memset(&f, 0, sizeof f);
    f.title = title; f.x_label = x; f.y_label = y;
    return f;
}

/* Curves: 0 T_tr(t), 1 T_tr/T_rot(t), both of one e; 2 T_tr(tau), 3 T_tot(tau); of many gases, 2
   from xi = 2 on and 3 below, as in [RUB15]. */
static void curves_draw(gas *gases, int count, int kind, double e) {
    static const char *const titles[4] = {
        "Translational temperature", "Translational over rotational temperature",
        "Translational temperature against Haff's law", "Total temperature against Haff's law"};
    static const char *const labels[4] = {"T_tr (J)", "T_tr / T_rot", "T_tr / T_tr(0)",
                                          "T_tot / T_tot(0)"};
    static const char *const files[4] = {"fig7_temperature.svg", "fig7_ratio.svg", "fig9_haff.svg",
                                         "fig10_haff_total.svg"};
    study_figure f = figure(titles[kind], kind < 2 ? "time (s)" : "tau = alpha Gamma_0 t",
                            labels[kind]);
    double *x[CASES], *y[CASES], law_x[100], law_y[100], longest = 0;
    char names[CASES][32];
    int c, i, drawn = 0;
    f.log_x = 1;
    f.log_y = kind != 1;
    for (c = 0; c < count && drawn < STUDY_CURVES - 1; c++) {
        gas *g = &gases[c];
        const int n = g->sample_count - 1;
        if (kind < 2 && fabs(g->e - e) > 1e-9) continue;
        if (kind == 1 && g->spheres) continue;
        if (kind > 1 && options.all && (kind == 2) != (g->xi >= 2)) continue;
        x[drawn] = (double *)study_alloc((size_t)n, sizeof(double));
        y[drawn] = (double *)study_alloc((size_t)n, sizeof(double));
        for (i = 0; i < n; i++) {
            const sample *a = &g->samples[i + 1];
            x[drawn][i] = kind < 2 ? a->time : g->tau_rate*a->time;
            y[drawn][i] = kind == 0 ? a->tr : kind == 1 ? a->tr/a->rot
                        : kind == 2 ? a->tr/g->samples[0].tr
                                    : total_of(g, a)/total_of(g, &g->samples[0]);
            longest = fmax(longest, g->tau_rate*a->time);
        }
        snprintf(names[drawn], sizeof names[drawn], "%.2f, e %.2f", g->xi, g->e);
        study_curve(&f, names[drawn], STUDY_LINE, n, x[drawn], y[drawn]);
        drawn++;
    }
    for (i = 0; i < 100; i++) {
        law_x[i] = longest*pow(1e-3, 1 - i/99.0);
        law_y[i] = pow(1 + law_x[i], -2);
    }
    if (kind > 1) study_curve(&f, "(1 + tau)^-2", STUDY_OUTLINE, 100, law_x, law_y);
    if (drawn) study_figure_write(&f, files[kind]);
    for (c = 0; c < drawn; c++) { free(x[c]); free(y[c]); }
}

/* T_tr/T_rot or cooling rate against elongation, with the theory's lines: Fig 8. */
static void elongation_draw(const gas *gases, int count, int cooling) {
    enum { POINTS = 40 };
    study_figure f = figure(cooling ? "Cooling rate" : "Translational over rotational temperature",
                            "elongation", cooling ? "zeta* / (1 - e^2)" : "T_tr / T_rot");
    double x[RESTITUTIONS][CASES], y[RESTITUTIONS][CASES], xi[POINTS], line[RESTITUTIONS][POINTS];
    char names[2*RESTITUTIONS][32];
    int r, c, i;
    for (i = 0; i < POINTS; i++) xi[i] = 1.1 + (3.2 - 1.1)*i/(POINTS - 1);
    for (i = 0; i < POINTS; i++) {
        theory t;
        theory_make(xi[i], &t);
        for (r = 0; r < RESTITUTIONS; r++) {
            double theta, zeta;
            theory_state(&t, restitutions[r], is(options.damping, "reduced"), &theta, &zeta);
            line[r][i] = cooling ? zeta/(1 - restitutions[r]*restitutions[r]) : 1/theta;
        }
    }
    for (r = 0; r < 2*RESTITUTIONS; r++) { /* lines, then dots of the same colours */
        const double e = restitutions[r%RESTITUTIONS];
        int n = 0;
        for (c = 0; c < count; c++) {
            if (fabs(gases[c].e - e) > 1e-9 || (gases[c].spheres && !cooling)) continue;
            x[r%RESTITUTIONS][n] = gases[c].xi;
            y[r%RESTITUTIONS][n++] = cooling ? gases[c].zeta/(1 - e*e) : gases[c].ratio;
        }
        snprintf(names[r], sizeof names[r], "e %.2f%s", e, r < RESTITUTIONS ? ", theory" : "");
        if (r < RESTITUTIONS) study_curve(&f, names[r], STUDY_LINE, POINTS, xi, line[r]);
        else study_curve(&f, n ? names[r] : 0, STUDY_DOTS, n, x[r%RESTITUTIONS], y[r%RESTITUTIONS]);
        if (r == RESTITUTIONS - 1) { /* study.h has six inks: the dots get those of the lines */
            int pad;
            for (pad = RESTITUTIONS; pad < 6; pad++) study_curve(&f, 0, STUDY_LINE, 0, xi, xi);
        }
    }
    study_figure_write(&f, cooling ? "fig8_cooling.svg" : "fig8_ratio.svg");
}

static void velocities_draw(const gas *g) {
    static const char *const names[3] = {"settling", "first half", "second half"};
    study_figure f = figure("Velocities, scaled", "v / v_rms, one component", "P");
    double c[BINS], p[4][BINS];
    int i, k;
    f.log_y = 1;
    f.x0 = -5; f.x1 = 5; f.y0 = -5; f.y1 = 0;
    for (i = 0; i < BINS; i++) {
        c[i] = 12*(i + 0.5)/BINS - 6;
        p[3][i] = exp(-c[i]*c[i]/2)/sqrt(2*PI);
        for (k = 0; k < 3; k++) p[k][i] = g->histogram[k][i]/g->histogram_sum[k]*BINS/12;
    }
    for (k = 0; k < 3; k++) study_curve(&f, names[k], STUDY_DOTS, BINS, c, p[k]);
    study_curve(&f, "Gauss", STUDY_OUTLINE, BINS, c, p[3]);
    study_figure_write(&f, "fig11_velocities.svg");
}

/* The elongations and restitutions that the options select. */
typedef struct choice { const double *xi, *e; int rows, pairs; } choice;
static choice chosen(void) {
    static const double few[4] = {1, 1.5, 2, 3};
    static double given[ELONGATIONS];
    choice c;
    int i;
    c.xi = options.xi > 0 ? &options.xi : options.all ? elongations : few;
    c.rows = options.xi > 0 ? 1 : options.all ? ELONGATIONS : 4;
    c.e = options.restitution > 0 ? &options.restitution : restitutions;
    c.pairs = options.restitution > 0 || !options.all ? 1 : RESTITUTIONS;
    if (*options.values) {
        c.xi = given;
        c.rows = study_values("values", options.values, given, ELONGATIONS);
        for (i = 0; i < c.rows; i++)
            if (!(given[i] >= 1 && given[i] <= 10)) {
                study_fail("--values has the elongation %g, must be from 1 to 10", given[i]);
                c.rows = 0;
            }
    }
    return c;
}

/* ---- the contact of two ellipsoids after [RUB15] ---- */

/* P = R diag(1/a2) R^T, row-major */
static void quadric(const dem_ellipsoid *e, double P[9]) {
    const double axes[3] = {e->semi_axes.x, e->semi_axes.y, e->semi_axes.z};
    int i, j, k;
    for (i = 0; i < 9; i++) P[i] = 0;
    for (k = 0; k < 3; k++) {
        const dem_vec3 along = dem_quat_rotate(e->orientation, dem_vec3_make(k == 0, k == 1, k == 2));
        const double u[3] = {along.x, along.y, along.z};
        for (i = 0; i < 3; i++) for (j = 0; j < 3; j++) P[3*i + j] += u[i]*u[j]/(axes[k]*axes[k]);
    }
}
static void adjoint(const double *P, double *A) {      /* of a symmetric matrix */
    int i, j;
    for (i = 0; i < 3; i++)
        for (j = 0; j < 3; j++) {
            const int a = (i + 1)%3, b = (i + 2)%3, c = (j + 1)%3, d = (j + 2)%3;
            A[3*i + j] = P[3*a + c]*P[3*b + d] - P[3*a + d]*P[3*b + c];
        }
}
static double product(const double *A, const double *B) { /* trace of A B, both symmetric */
    double sum = 0;
    int i;
    for (i = 0; i < 9; i++) sum += A[i]*B[i];
    return sum;
}
static double bilinear(const double *A, const double *v) {
    return v[0]*(A[0]*v[0] + A[1]*v[1] + A[2]*v[2]) + v[1]*(A[3]*v[0] + A[4]*v[1] + A[5]*v[2]) +
           v[2]*(A[6]*v[0] + A[7]*v[1] + A[8]*v[2]);
}
/* The quartic det(t A + B) of eq 9 and 10 for two ellipsoids shrunk by W: det K(t) (m + w - (1 - w) t) - v.adj(K(t)) v, with
   K = t PA + PB, d from a to b, v = PB d, m = d.v - 1, w = 1 - W2. The search for W changes w alone. */
typedef struct quartic { double PA[9], PB[9], v[3], k[4], q[3], m; } quartic;
static quartic quartic_of(const dem_ellipsoid *a, const dem_ellipsoid *b) {
    const double d[3] = {b->position.x - a->position.x, b->position.y - a->position.y, b->position.z - a->position.z};
    quartic f;
    double A[9], B[9], sum[9], both[9];
    int i;
    quadric(a, f.PA);
    quadric(b, f.PB);
    for (i = 0; i < 3; i++) f.v[i] = f.PB[3*i]*d[0] + f.PB[3*i + 1]*d[1] + f.PB[3*i + 2]*d[2];
    for (i = 0; i < 9; i++) sum[i] = f.PA[i] + f.PB[i];
    adjoint(f.PA, A);
    adjoint(f.PB, B);
    adjoint(sum, both);
    f.k[3] = product(A, f.PA)/3; f.k[2] = product(A, f.PB); f.k[1] = product(B, f.PA); f.k[0] = product(B, f.PB)/3;
    f.q[2] = bilinear(A, f.v); f.q[0] = bilinear(B, f.v);
    f.q[1] = bilinear(both, f.v) - f.q[2] - f.q[0];
    f.m = dot3(d, f.v) - 1;
    return f;
}
static void quartic_at(const quartic *f, double W, double c[5]) {
    const double w = 1 - W*W;
    int i;
    for (i = 0; i < 5; i++)
        c[i] = (i < 4 ? (f->m + w)*f->k[i] : 0) - (i ? (1 - w)*f->k[i - 1] : 0) - (i < 3 ? f->q[i] : 0);
}
/* Eq 11 and the sign of P: returns 1 if the two are apart. */
static int quartic_apart(const double c[5]) {
    const double A = c[4], B = c[3], C = c[2], D = c[1], E = c[0];
    const double delta = 256*A*A*A*E*E*E - 192*A*A*B*D*E*E - 128*A*A*C*C*E*E + 144*A*A*C*D*D*E - 27*A*A*D*D*D*D +
        144*A*B*B*C*E*E - 6*A*B*B*D*D*E - 80*A*B*C*C*D*E + 18*A*B*C*D*D*D + 16*A*C*C*C*C*E - 4*A*C*C*C*D*D -
        27*B*B*B*B*E*E + 18*B*B*B*C*D*E - 4*B*B*B*D*D*D - 4*B*B*C*C*C*E + B*B*C*C*D*D;
    return delta > 0 && 8*A*C - 3*B*B < 0;
}
/* Searches the shrinkage W at which the two touch, by bisection to `within`; then the eigenvector of the double root, which is
   the contact point relative to a, and the normal there. */
static double quartic_contact(const dem_ellipsoid *a, const dem_ellipsoid *b, double within, double n[3]) {
    const quartic f = quartic_of(a, b);
    double lo = 0.5, hi = 1, c[5], K[9], J[9], x[3], t, more = 1;
    int i;
    while (hi - lo > within) {
        const double middle = (lo + hi)/2;
        quartic_at(&f, middle, c);
        if (quartic_apart(c)) lo = middle; else hi = middle;
    }
    quartic_at(&f, lo, c);
    for (t = 0, i = 0; i < 4; i++) t = fmax(t, fabs(c[i]/c[4]));
    for (t += 1, i = 0; i < 60 && fabs(more) > 1e-12*t; i++) {      /* Newton from above: the largest root of f' */
        more = (((4*c[4]*t + 3*c[3])*t + 2*c[2])*t + c[1])/((12*c[4]*t + 6*c[3])*t + 2*c[2]);
        t -= more;
    }
    for (i = 0; i < 9; i++) K[i] = t*f.PA[i] + f.PB[i];
    adjoint(K, J);
    for (i = 0; i < 3; i++) x[i] = dot3(J + 3*i, f.v)*3/product(J, K);
    for (i = 0; i < 3; i++) n[i] = dot3(f.PA + 3*i, x);
    unit3(n);
    return lo;
}

/* Times both on the same pairs, which overlap by up to 1 % of their size, as in the gas. */
static void contact_run(void) {
    enum { PAIRS = 1000 };
    static dem_ellipsoid pair[PAIRS][2];
    static double lambda[PAIRS];
    static const char *const names[4] = {"contact.function", "contact.function_warm", "contact.quartic", "contact.sign_test"};
    double time[4][20], worst[2] = {0, 0}, iterations = 0, sum = 0;
    static gas g;
    int i, k, n, kind;
    g.random = (uint64_t)options.seed;
    if (!(options.xi > 0)) options.xi = 2;
    for (i = 0; i < PAIRS; i++) {
        dem_ellipsoid_contact c;
        double d[3], W = 0.99 + 0.01*uniform(&g), n_quartic[3];
        for (k = 0; k < 2; k++) {
            pair[i][k].semi_axes = dem_vec3_make(1, 1, options.xi);
            pair[i][k].orientation = dem_quat_make(normal(&g), normal(&g), normal(&g), normal(&g));
            { /* of length one */
                dem_quat *q = &pair[i][k].orientation;
                const double l = sqrt(q->w*q->w + q->x*q->x + q->y*q->y + q->z*q->z);
                *q = dem_quat_make(q->w/l, q->x/l, q->y/l, q->z/l);
            }
            d[k] = normal(&g);
        }
        d[2] = normal(&g);
        unit3(d);
        pair[i][0].position = dem_vec3_make(0, 0, 0);
        pair[i][1].position = dem_vec3_make(d[0], d[1], d[2]);
        W /= dem_ellipsoids_contact_get(&pair[i][0], &pair[i][1], 0).scale;
        pair[i][1].position = dem_vec3_make(W*d[0], W*d[1], W*d[2]);
        c = dem_ellipsoids_contact_get(&pair[i][0], &pair[i][1], 0);
        lambda[i] = c.lambda;
        iterations += c.iterations/(double)PAIRS;
        worst[0] = fmax(worst[0], fabs(quartic_contact(&pair[i][0], &pair[i][1], 1e-6, n_quartic)/c.scale - 1));
        worst[1] = fmax(worst[1], 1 - fabs(n_quartic[0]*c.normal.x + n_quartic[1]*c.normal.y + n_quartic[2]*c.normal.z));
    }
    for (n = 0; n < options.repeats; n++)
        for (kind = 0; kind < 4; kind++) {
            const double begun = (double)clock()/CLOCKS_PER_SEC;
            double spent = 0, rounds = 0;
            while (spent < (options.brief ? 0.02 : 0.3)) {
                for (i = 0; i < PAIRS; i++) {
                    double n_quartic[3], c[5];
                    if (kind < 2) sum += dem_ellipsoids_contact_get(&pair[i][0], &pair[i][1], kind ? lambda[i] : 0).scale;
                    else if (kind == 2) sum += quartic_contact(&pair[i][0], &pair[i][1], 1e-6, n_quartic);
                    else {
                        const quartic f = quartic_of(&pair[i][0], &pair[i][1]);
                        quartic_at(&f, 1, c);
                        sum += quartic_apart(c);
                    }
                }
                rounds++;
                spent = (double)clock()/CLOCKS_PER_SEC - begun;
            }
            time[kind][n] = 1e9*spent/rounds/PAIRS;
        }
    for (kind = 0; kind < 4; kind++) study_mean_tell(names[kind], time[kind], options.repeats, "ns");
    study_result("contact.iterations", iterations, "");
    study_result("contact.scale_difference", worst[0], "");
    study_result("contact.normal_difference", sqrt(2*worst[1]), "rad");
    if (!(sum > 0) || worst[0] > 1e-5) study_fail("the quartic and the contact function differ by %g", worst[0]);
}

/* Runs the same case with each scheme (or of each spread of sizes) and all seeds; means and standard errors. */
static void schemes_run(void) {
    static const char *const schemes[5][2] = {{"verlet", "spiral"}, {"verlet", "fincham"}, {"leapfrog", "fincham"},
                                              {"symplectic", "spiral"}, {"euler", "spiral"}};
    static const double spreads[3] = {0, 0.2, 0.4};
    static gas g;
    const int first = options.seed, rows = options.sizes ? 3 : 5;
    int row, i;
    if (!(options.xi > 0)) options.xi = options.sizes ? 1.5 : 2;
    if (!(options.restitution > 0)) options.restitution = 0.9;
    for (row = 0; row < rows; row++) {
        double found[5][20];
        char start[48], name[80];
        if (options.sizes) {
            options.spread = spreads[row];
            snprintf(start, sizeof start, "spread%g", spreads[row]);
        } else {
            options.integrator = schemes[row][0];
            options.rotation = schemes[row][1];
            snprintf(start, sizeof start, "%s_%s", schemes[row][0], schemes[row][1]);
        }
        for (i = 0; i < options.repeats; i++) {
            options.seed = first + i;
            snprintf(study.prefix, sizeof study.prefix, "%s.seed%d.", start, options.seed);
            if (gas_case(&g, options.xi, options.restitution)) { gas_destroy(&g); study.prefix[0] = 0; return; }
            found[0][i] = g.drift;
            found[1][i] = g.ratio;
            found[2][i] = g.zeta;
            found[3][i] = g.fourth/g.fourth_sum/3 - 1;
            found[4][i] = g.heavy;
            gas_destroy(&g);
        }
        study.prefix[0] = 0;
        for (i = 0; i < (options.spread > 0 ? 5 : 4); i++) {
            static const char *const names[5] = {"run_in_drift", "T_ratio", "zeta_star", "kurtosis", "heavy_ratio"};
            snprintf(name, sizeof name, "%s.%s", start, names[i]);
            study_mean_tell(name, found[i], options.repeats, "");
        }
    }
}

static void direct_run(void) {
    const choice c = chosen();
    int i, k;
    for (k = 0; k < c.pairs; k++)
        for (i = 0; i < c.rows; i++) direct_case(c.xi[i], c.e[k]);
}

static void cases_run(void) {
    static gas gases[CASES];
    const choice c = chosen();
    int i, k, count = 0, drawn;
    double *data[8];
    if (!c.rows) return;
    study_result("count", pow((int)(cbrt(options.count) + 0.5), 3), "");
    for (k = 0; k < c.pairs; k++)
        for (i = 0; i < c.rows; i++) {
            if (gas_case(&gases[count], c.xi[i], c.e[k])) { gas_destroy(&gases[count]); return; }
            count++;
        }
    for (k = 0; k < 8; k++) data[k] = (double *)study_alloc((size_t)count, sizeof(double));
    for (i = 0; i < count; i++) {
        const gas *g = &gases[i];
        data[0][i] = g->xi;
        data[1][i] = g->e;
        data[2][i] = g->spheres ? 1 : g->ratio;
        data[3][i] = g->ratio_theory;
        data[4][i] = g->zeta;
        data[5][i] = g->zeta_theory;
        data[6][i] = g->t.area;
        data[7][i] = g->t.d_root;
    }
    study_csv("cases.csv", "xi,e,T_ratio,T_ratio_theory,zeta_star,zeta_star_theory,S_c,root_mean",
              count, 8, (const double *const *)data);
    for (k = 0; k < 4; k++) curves_draw(gases, count, k, options.all ? 0.95 : gases[0].e);
    elongation_draw(gases, count, 0);
    elongation_draw(gases, count, 1);
    for (drawn = 0; drawn + 1 < count && gases[drawn].xi < 2; drawn++) {}
    velocities_draw(&gases[drawn]);
    for (k = 0; k < 8; k++) free(data[k]);
    for (i = 0; i < count; i++) gas_destroy(&gases[i]);
}

/* Returns s of processor time for one thread, so that other programs do not count; s of wall time for
   more. */
static double seconds_spent(void) {
    return options.threads == 1 && options.slabs < 2 ? (double)clock()/CLOCKS_PER_SEC : study_clock();
}

/* Table 2: bodies times steps per second, ellipsoids of xi = 2 and spheres, e = .95. */
static void speeds_run(void) {
    static const double seed[2][5] = {{1.1e5, 7.4e5, 3.9e6, 4.5e6, 4.2e6},
                                      {2.4e5, 1.5e6, 5.8e6, 7.7e6, 8.2e6}};
    double data[5][5];
    const double *columns[5] = {data[0], data[1], data[2], data[3], data[4]};
    const int sizes = options.brief ? 3 : 5;
    int size, kind;
    for (size = 0; size < sizes; size++) {
        data[0][size] = pow(8, size + 2);
        for (kind = 0; kind < 2; kind++) {
            static gas g;
            char name[64];
            dem_slabs *slabs = 0;
            double begun, spent = 0, steps = 0, temperature;
            int batch = 1, bad = gas_create(&g, kind ? 1 : 2, 0.95, (int)data[0][size]);
            temperature = g.mass*pow(options.overlap/2*g.radius, 2)/(g.mass/2/STIFFNESS);
            if (!bad) {
                dem_pair pair;
                bad = refused(g.world, dem_pair_get(g.world, g.material, g.material, &pair));
                pair.restitution = 0.95;
                bad = bad || refused(g.world, dem_pair_set(g.world, g.material, g.material, &pair));
            }
            bad = bad || gas_fill(&g, temperature, 1);
            bad = bad || refused(g.world, dem_world_step(g.world, 200));      /* warm */
            if (!bad && options.slabs) {
                dem_slabs_desc desc = DEM_SLABS_DESC;
                desc.count = desc.local = options.slabs;
                slabs = dem_slabs_create(g.world, &desc);
                bad = !slabs && refused(g.world, DEM_ERROR_ARGUMENT);
            }
            while (!bad && spent < options.seconds) {
                begun = seconds_spent();
                if (slabs && dem_slabs_step(slabs, batch) != DEM_OK) {
                    study_fail("%s", dem_slabs_error_get(slabs));
                    bad = 1;
                } else if (!slabs) bad = refused(g.world, dem_world_step(g.world, batch));
                spent += seconds_spent() - begun;
                steps += batch;
                if (spent < options.seconds/20) batch *= 2;
            }
            dem_slabs_destroy(slabs);
            if (bad) { gas_destroy(&g); return; }
            snprintf(name, sizeof name, "speed.%s.%d", kind ? "spheres" : "ellipsoids", g.count);
            study_result(name, steps*g.count/spent, "body-steps/s");
            snprintf(name, sizeof name, "speed.%s.%d.seed", kind ? "spheres" : "ellipsoids",
                     g.count);
            study_result(name, seed[kind][size], "body-steps/s, of [RUB15]");
            data[1 + 2*kind][size] = steps*g.count/spent;
            data[2 + 2*kind][size] = seed[kind][size];
            gas_destroy(&g);
        }
    }
    study_csv("speeds.csv", "bodies,ellipsoids,ellipsoids_seed,spheres,spheres_seed", sizes, 5,
              columns);
}

int main(int argc, char **argv) {
    const char *about = "A granular gas of ellipsoids that cools.";
    const int count = (int)(sizeof table/sizeof *table);
    study_options(argc, argv, about, table, count);
    if (options.quick) { /* options given by name keep their values */
        options.xi = 2;
        options.restitution = 0.9;
        options.collisions = 15;
        options.run_in = 4;
        study_options(argc, argv, about, table, count);
    }
    if (options.brief) {
        options.count = 64;
        options.collisions = 3;
        options.run_in = 0.5;
        options.seconds = 0.05;
        options.repeats = 1;
    }
    study_begin(options.out);
    if (options.theory || options.speeds || options.contact || options.integrators || options.sizes)
        study_values_unused(options.values, "a run with --theory, --speeds, --contact, --integrators or --sizes");
    if (options.theory) theory_tell();
    else if (options.direct) direct_run();
    else if (options.speeds) speeds_run();
    else if (options.contact) contact_run();
    else if (options.integrators || options.sizes) schemes_run();
    else cases_run();
    return study_end();
}
