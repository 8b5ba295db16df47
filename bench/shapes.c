/* shapes.c - what bodies that are not spheres cost: meetings of ellipsoids, rotation, whole steps. MIT licence.

   build/shapes            about a minute; results in build/out/shapes, among them page.md for docs/shapes.md and
                           ellipsoids.csv, rotation.csv and bed.csv for docs/data
   build/shapes --part meet|rotation|pile

   meet      Perram and Wertheim's function solved for 100,000 pairs of each aspect ratio, scaled distance W0 in
             .98..1: from nothing (cold), from the solution of a moment ago (warm: turned by 1e-4 rad and moved by
             1e-4 of the shortest axis); error against a bisection in long double; how many of pairs with W0 in 1..2
             are told apart at the first look
   rotation  a free body of moments 1, 2, 2.6 and |w| = 1.2 for 40 s: error of its orientation against the smallest
             step, energy after 2000 s, and the time of a step, for every integrator
   pile      a bed at rest of 1000 spheres, ellipsoids, tetrahedra of spheres: time of a step and body */
#define DEM_IMPLEMENTATION
#include "dem.h"
#include "examples/study.h"
#include "bench/measure.h"

enum { PAIRS = 100000, CHECKED = 3000, TURNS = 5, RATIOS = 7 };
static const double ratios[RATIOS] = {1.0001, 1.5, 2, 3, 10, 30, 100};
static FILE *page, *csv;

/* ---- meet ---- */

typedef struct meeting { demi_sym A, B; demi_d3 r; double l; } meeting;
static meeting now[PAIRS], then[PAIRS];          /* and a moment ago */
static uint64_t seed = 7;

static void jog(double *x) { *x += 2e-4*(demi_uniform(&seed) - 0.5); }
/* All orientations are equally likely. */
static dem_quat orientation(void) {
    const double u = demi_uniform(&seed), a = 2*DEMI_PI*demi_uniform(&seed), b = 2*DEMI_PI*demi_uniform(&seed);
    const double r = sqrt(1 - u), s = sqrt(u);
    return dem_quat_make((dem_real)(r*sin(a)), (dem_real)(r*cos(a)), (dem_real)(s*sin(b)), (dem_real)(s*cos(b)));
}
static double start(demi_sym A, demi_sym B, demi_d3 r) {
    return demi_meet_start(demi_sym_height(A, r), demi_sym_height(B, r));
}
static void pair_make(int i, double ratio) {
    const dem_vec3 e = dem_quat_rotate(orientation(), dem_vec3_make(0, 0, 1));
    meeting *m = &now[i], *was = &then[i];
    demi_meet found;
    double s, by[3];
    int k, n;
    for (k = 0; k < 2; k++) {
        const dem_quat q = orientation();
        dem_vec3 a;
        dem_quat p;
        a.x = 1; a.y = (dem_real)pow(ratio, demi_uniform(&seed)); a.z = (dem_real)ratio;
        *(k ? &m->B : &m->A) = demi_ellipsoid_matrix(q, a);
        for (n = 0; n < 3; n++) { by[n] = 0; jog(&by[n]); }
        p = demi_quat_again(dem_quat_multiply(q, demi_quat_exp(dem_vec3_make((dem_real)by[0], (dem_real)by[1],
                                                                      (dem_real)by[2]))));
        *(k ? &was->B : &was->A) = demi_ellipsoid_matrix(p, a);
    }
    m->r = demi_d((double)e.x, (double)e.y, (double)e.z);
    found.l = start(m->A, m->B, m->r);
    demi_meet_solve(m->A, m->B, m->r, 1e300, 1e-12, &found);
    s = (0.98 + 0.02*demi_uniform(&seed))/sqrt(found.f);
    m->r = was->r = demi_d3_scale(m->r, s);
    jog(&was->r.x); jog(&was->r.y); jog(&was->r.z);
    found.l = start(was->A, was->B, was->r);
    demi_meet_solve(was->A, was->B, was->r, 1e300, DEMI_MEET_NEAR, &found);
    m->l = found.l;
}
/* W0 and normal by bisection in long double. */
static void pair_exact(const meeting *m, long double *w0, long double *n) {
    long double lo = 0, hi = 1, f = 0, s[3] = {0, 0, 0}, size = 0, A[6], B[6], r[3];
    const double a[6] = {m->A.xx, m->A.yy, m->A.zz, m->A.xy, m->A.xz, m->A.yz};
    const double b[6] = {m->B.xx, m->B.yy, m->B.zz, m->B.xy, m->B.xz, m->B.yz};
    const double between[3] = {m->r.x, m->r.y, m->r.z};
    int k, turn;
    for (k = 0; k < 6; k++) { A[k] = (long double)a[k]; B[k] = (long double)b[k]; }
    for (k = 0; k < 3; k++) r[k] = (long double)between[k];
    for (turn = 0; turn < 64; turn++) {
        const long double l = (lo + hi)/2;
        long double K[6], J[6], det, fa = 0, fb = 0;
        for (k = 0; k < 6; k++) K[k] = (1 - l)*A[k] + l*B[k];
        J[0] = K[1]*K[2] - K[5]*K[5]; J[3] = K[4]*K[5] - K[3]*K[2]; J[4] = K[3]*K[5] - K[1]*K[4];
        J[1] = K[0]*K[2] - K[4]*K[4]; J[5] = K[3]*K[4] - K[0]*K[5]; J[2] = K[0]*K[1] - K[3]*K[3];
        det = K[0]*J[0] + K[3]*J[3] + K[4]*J[4];
        s[0] = (J[0]*r[0] + J[3]*r[1] + J[4]*r[2])/det;
        s[1] = (J[3]*r[0] + J[1]*r[1] + J[5]*r[2])/det;
        s[2] = (J[4]*r[0] + J[5]*r[1] + J[2]*r[2])/det;
        for (k = 0; k < 2; k++) {
            const long double *Q = k ? B : A;
            const long double q = s[0]*(Q[0]*s[0] + 2*Q[3]*s[1] + 2*Q[4]*s[2]) + s[1]*(Q[1]*s[1] + 2*Q[5]*s[2]) +
                s[2]*Q[2]*s[2];
            if (k) fb = l*l*q; else fa = (1 - l)*(1 - l)*q;
        }
        f = l*(1 - l)*(r[0]*s[0] + r[1]*s[1] + r[2]*s[2]);
        if (fa > fb) lo = l; else hi = l;
    }
    for (k = 0; k < 3; k++) size += s[k]*s[k];
    for (k = 0; k < 3; k++) n[k] = s[k]/sqrtl(size);
    *w0 = sqrtl(f);
}
/* on_page: the page shows this one; ellipsoids.csv has all */
static void meet_run(double ratio, int on_page) {
    double cold[TURNS], warm[TURNS], sum = 0, scale_error = 0, normal_error = 0, square = 0;
    long looks[2] = {0, 0};
    int worst[2] = {0, 0}, early = 0, i, k, turn;
    demi_meet m;
    char name[64];
    for (i = 0; i < PAIRS; i++) pair_make(i, ratio);
    for (turn = 0; turn < TURNS; turn++) {
        double begun = study_clock();
        for (i = 0; i < PAIRS; i++) {
            m.l = start(now[i].A, now[i].B, now[i].r);
            demi_meet_solve(now[i].A, now[i].B, now[i].r, 1, DEMI_MEET_NEAR, &m);
            sum += m.s.x;
            looks[0] += m.iterations;
            worst[0] = m.iterations > worst[0] ? m.iterations : worst[0];
        }
        cold[turn] = 1e9*(study_clock() - begun)/PAIRS;
        begun = study_clock();
        for (i = 0; i < PAIRS; i++) {
            m.l = now[i].l;
            demi_meet_solve(now[i].A, now[i].B, now[i].r, 1, DEMI_MEET_NEAR, &m);
            sum += m.s.x;
            looks[1] += m.iterations;
            worst[1] = m.iterations > worst[1] ? m.iterations : worst[1];
        }
        warm[turn] = 1e9*(study_clock() - begun)/PAIRS;
    }
    if (sum == 1.2345) puts("");                 /* so that nothing is left out */
    for (i = 0; i < CHECKED; i++) {
        double n[3], ha, hb, d = 0;
        demi_d3 normal;
        long double w0, e[3];
        m.l = start(now[i].A, now[i].B, now[i].r);
        demi_meet_solve(now[i].A, now[i].B, now[i].r, 1, DEMI_MEET_NEAR, &m);
        demi_meet_heights(&m, &normal, &ha, &hb);
        n[0] = normal.x; n[1] = normal.y; n[2] = normal.z;
        pair_exact(&now[i], &w0, e);
        scale_error = fmax(scale_error, fabs((double)(sqrtl((long double)m.f) - w0)));
        for (k = 0; k < 3; k++) d += (double)(((long double)n[k] - e[k])*((long double)n[k] - e[k]));
        normal_error = fmax(normal_error, sqrt(d));
        square += d;
    }
    for (i = 0; i < PAIRS; i++) {
        const demi_d3 r = demi_d3_scale(now[i].r, 1 + demi_uniform(&seed));
        m.l = start(now[i].A, now[i].B, r);
        demi_meet_solve(now[i].A, now[i].B, r, 1, DEMI_MEET_NEAR, &m);
        early += m.iterations == 1 && m.f > 1;
    }
    snprintf(name, sizeof name, "meet.ratio%g.cold", ratio < 1.01 ? 1 : ratio);
    bench_result_short(name, bench_median(cold, TURNS), "ns");
    snprintf(name, sizeof name, "meet.ratio%g.warm", ratio < 1.01 ? 1 : ratio);
    bench_result_short(name, bench_median(warm, TURNS), "ns");
    if (page && on_page)
        fprintf(page, "| %g | %.0f | %.0f | %.2f | %.2f | %.0e | %.1f |\n", ratio < 1.01 ? 1 : ratio,
                bench_median(cold, TURNS), bench_median(warm, TURNS), (double)looks[0]/PAIRS/TURNS,
                (double)looks[1]/PAIRS/TURNS, sqrt(square/CHECKED), 100.0*early/PAIRS);
    if (csv)
        fprintf(csv, "%g,%.0f,%.2f,%d,%.0f,%.2f,%d,%.0e,%.0e,%.0e,%.1f\n", ratio < 1.01 ? 1 : ratio,
                bench_median(cold, TURNS), (double)looks[0]/PAIRS/TURNS, worst[0], bench_median(warm, TURNS),
                (double)looks[1]/PAIRS/TURNS, worst[1], scale_error, sqrt(square/CHECKED), normal_error,
                100.0*early/PAIRS);
}
static void meet_part(void) {
    int i;
    if (page)
        fprintf(page, "\n### Contact detection of two ellipsoids\n\n| aspect ratio | cold start, ns | warm start, ns | "
                "iterations, cold | iterations, warm | rms error of the normal | separate pairs rejected in one "
                "iteration, %% |\n|---|---|---|---|---|---|---|\n");
    csv = bench_table_open("ellipsoids.csv", "aspect_ratio,cold_ns,cold_iterations_mean,cold_iterations_max,warm_ns,"
                             "warm_iterations_mean,warm_iterations_max,W0_error_max,normal_error_rms,normal_error_max,"
                             "rejected_in_one_iteration_percent");
    for (i = 0; i < RATIOS; i++) meet_run(ratios[i], i%2 == 0);
    study_close(csv, "ellipsoids.csv");
}

/* ---- rotation ---- */

static const char *const rotations[3] = {"spiral", "fincham", "no_squish"};
static const char *const rotation_names[3] = {"DEM_ROTATION_SPIRAL", "DEM_ROTATION_FINCHAM", "DEM_ROTATION_NO_SQUISH"};
static dem_world *top_world(int rotation, double dt, int count) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc m = DEM_MATERIAL_DESC;
    dem_cluster_desc c = DEM_CLUSTER_DESC;
    const dem_real x[3] = {0, 0, 0};
    dem_real *at = (dem_real *)study_alloc(3*(size_t)count, sizeof(dem_real));
    dem_real *spin = (dem_real *)study_alloc(3*(size_t)count, sizeof(dem_real));
    dem_world *w;
    int i;
    desc.rotation = (dem_rotation)rotation;
    desc.dt = (dem_real)dt;
    desc.allow_large_dt = 1;
    desc.threads = 1;
    w = dem_world_create(&desc);
    m.density = 1;
    m.young = (dem_real)1e6;
    m.restitution = 1;
    c.count = 1;
    c.positions = x;
    c.radius = (dem_real)0.1;
    c.mass = DEM_CLUSTER_GIVEN;
    c.volume = 1;
    c.inertia[0] = 1; c.inertia[1] = 2; c.inertia[2] = (dem_real)2.6;
    for (i = 0; i < count; i++) {
        at[3*i] = (dem_real)(3*i);
        spin[3*i] = (dem_real)0.4; spin[3*i + 1] = (dem_real)0.9; spin[3*i + 2] = (dem_real)0.7;
    }
    if (dem_bodies_add(w, dem_material_add(w, &m), dem_shape_cluster_add(w, &c), count, at, 0, 0, spin, 0) != DEM_OK)
        study_fail("%s", dem_world_error_get(w));
    free(at);
    free(spin);
    return w;
}
static dem_quat top_fly(int rotation, double dt, double time, double *energy) {
    dem_world *w = top_world(rotation, dt, 1);
    dem_body_state s;
    const double first = dem_totals_get(w).rotational;
    if (dem_world_step(w, (int)(time/dt + 0.5)) != DEM_OK) study_fail("%s", dem_world_error_get(w));
    dem_body_get(w, dem_body_id_get(w, 0), &s);
    *energy = dem_totals_get(w).rotational/first - 1;
    dem_world_destroy(w);
    return s.orientation;
}
static double quat_apart(dem_quat a, dem_quat b) {
    const dem_quat d = dem_quat_multiply(dem_quat_make(a.w, -a.x, -a.y, -a.z), b);
    return 2*sqrt((double)(d.x*d.x + d.y*d.y + d.z*d.z));
}
static double turn_price(int rotation) { /* ns of a step and body */
    double times[TURNS];
    dem_world *w = top_world(rotation, 1e-2, 4096);
    int turn;
    dem_world_step(w, 20);
    for (turn = 0; turn < TURNS; turn++) {
        const double begun = study_clock();
        dem_world_step(w, 200);
        times[turn] = 1e9*(study_clock() - begun)/200/4096;
    }
    dem_world_destroy(w);
    return bench_median(times, TURNS);
}
static void rotation_part(void) {
    const double steps[3] = {0.1, 0.025, 0.00625};
    double energy;
    const dem_quat exact = top_fly(DEM_ROTATION_SPIRAL, 1e-4, 40, &energy);
    int i, k;
    if (page)
        fprintf(page, "\n### Integrators of rotation\n\n| `desc.rotation` | order | error of the orientation at dt = 0.025 "
                "s, rad | relative change of energy in 2000 s at dt = 0.02 s | time of a step and body, ns |\n"
                "|---|---|---|---|---|\n");
    csv = bench_table_open("rotation.csv", "rotation,error_dt_0.1_s_rad,error_dt_0.025_s_rad,error_dt_0.00625_s_rad,order,"
                             "energy_change_dt_0.1_s,energy_change_dt_0.02_s,step_and_body_ns");
    for (i = 0; i < 3; i++) {
        double error[3], drift[2], price = turn_price(i);
        char name[64];
        for (k = 0; k < 3; k++) error[k] = quat_apart(exact, top_fly(i, steps[k], 40, &energy));
        for (k = 0; k < 2; k++) (void)top_fly(i, k ? 0.02 : 0.1, 2000, &drift[k]);
        for (k = 0; k < 3; k++) {
            snprintf(name, sizeof name, "rotation.%s.error_dt%g", rotations[i], steps[k]);
            bench_result_short(name, error[k], "rad");
        }
        snprintf(name, sizeof name, "rotation.%s.energy_drift", rotations[i]);
        bench_result_short(name, drift[1], "");
        snprintf(name, sizeof name, "rotation.%s.price", rotations[i]);
        bench_result_short(name, price, "ns");
        if (page)
            fprintf(page, "| `%s` | %.1f | %.1e | %+.1e | %.0f |\n", rotation_names[i], log(error[1]/error[2])/log(4.0),
                    error[1], drift[1], price);
        if (csv)
            fprintf(csv, "%s,%.1e,%.1e,%.1e,%.1f,%+.1e,%+.1e,%.0f\n", rotation_names[i], error[0], error[1], error[2],
                    log(error[1]/error[2])/log(4.0), drift[0], drift[1], price);
    }
    study_close(csv, "rotation.csv");
}

/* ---- pile ---- */

static const char *const kinds[4] = {"spheres", "ellipsoids", "tetrahedra", "rods"};
static const char *const kind_names[4] = {"spheres", "ellipsoids, 1.5 : 1 : 1", "clusters of four spheres, tetrahedra",
                                          "clusters of three spheres, rods"};
static dem_shape kind_shape(dem_world *w, int kind, double volume) {
    const double r = cbrt(volume*3/(4*DEMI_PI));
    dem_cluster_desc c = DEM_CLUSTER_DESC;
    dem_real x[12];
    int i;
    if (kind == 1)
        return dem_shape_ellipsoid_add(w, dem_vec3_make((dem_real)(r/cbrt(1.5)), (dem_real)(r/cbrt(1.5)),
                                                        (dem_real)(1.5*r/cbrt(1.5))));
    c.radius = (dem_real)(r/cbrt(kind == 2 ? 4.0 : 3.0));
    c.count = kind == 2 ? 4 : 3;
    for (i = 0; i < 12; i++) {                  /* touching spheres: corners of a tetrahedron, or in a row */
        static const int corner[12] = {1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1};
        x[i] = kind == 2 ? c.radius*(dem_real)(corner[i]/sqrt(2.0)) : i%3 == 0 && i < 9 ? 2*c.radius*(dem_real)(i/3) : 0;
    }
    c.positions = x;
    return dem_shape_cluster_add(w, &c);
}
static void pile_part(void) {
    const double volume = 4/3.0*DEMI_PI*1e-9;
    double first = 0;
    char name[64];
    int kind, k;
    if (page)
        fprintf(page, "\n### A bed of 1000 bodies at rest\n\n| bodies | contacts per body | time of a step and body, ns | the "
                "same per contact, ns | time over that of spheres |\n|---|---|---|---|---|\n");
    csv = bench_table_open("bed.csv", "bodies,contacts_per_body,step_and_body_ns,step_and_contact_ns,time_over_spheres");
    for (kind = 0; kind < 4; kind++) {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_material_desc m = DEM_MATERIAL_DESC;
        double times[TURNS], cost, contacts;
        dem_material stuff;
        dem_world *w;
        dem_counters c;
        int n;
        desc.normal_law = DEM_NORMAL_LINEAR;
        desc.gravity.z = (dem_real)-9.81;
        desc.domain = dem_box_make(0, 0, -1, (dem_real)0.025, (dem_real)0.025, 1);
        desc.boundary[0] = desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
        desc.threads = 1;
        w = dem_world_create(&desc);
        m.density = 2500;
        m.stiffness = 500;
        m.restitution = (dem_real)0.3;
        m.friction = (dem_real)0.5;
        stuff = dem_material_add(w, &m);
        dem_wall_plane_add(w, stuff, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
        n = kind ? dem_bodies_fill(w, stuff, kind_shape(w, kind, volume),
                                   dem_region_make(dem_box_make(0, 0, 0, (dem_real)0.025, (dem_real)0.025, (dem_real)0.4)),
                                   1000, 3)
            : dem_spheres_fill(w, stuff, (dem_real)1e-3,
                               dem_region_make(dem_box_make(0, 0, 0, (dem_real)0.025, (dem_real)0.025, (dem_real)0.4)),
                               1000, 3);
        if (n != 1000 || dem_world_run(w, 0.35, 0, 0) != DEM_OK) study_fail("%s", dem_world_error_get(w));
        for (k = 0; k < TURNS; k++) {
            const double begun = study_clock();
            if (dem_world_step(w, 300) != DEM_OK) study_fail("%s", dem_world_error_get(w));
            times[k] = 1e9*(study_clock() - begun)/300/1000;
        }
        c = dem_counters_get(w);
        cost = bench_median(times, TURNS);
        contacts = (c.contacts + c.wall_contacts)/1000.0;
        if (!kind) first = cost;
        snprintf(name, sizeof name, "pile.%s.step", kinds[kind]);
        bench_result_short(name, cost, "ns");
        if (page)
            fprintf(page, "| %s | %.2f | %.0f | %.0f | %.1f |\n", kind_names[kind], contacts, cost, cost/contacts, cost/first);
        if (csv)
            fprintf(csv, "%s,%.2f,%.0f,%.0f,%.1f\n", kinds[kind], contacts, cost, cost/contacts, cost/first);
        dem_world_destroy(w);
    }
    study_close(csv, "bed.csv");
}

int main(int argc, char **argv) {
    static const char *part = "all", *out = "build/out/shapes";
    static const study_option table[] = {
        {"part", STUDY_TEXT, &part, 0, 0, "", "meet, rotation, pile or all"},
        {"out", STUDY_TEXT, &out, 0, 0, "", "folder of results"},
    };
    const double load = bench_load();
    const int all = 0 == (study_options(argc, argv, "What bodies that are not spheres cost.", table,
                                        (int)(sizeof table/sizeof *table)), strcmp(part, "all"));
    study_begin(out);
    bench_machine();
    page = bench_page_open();
    if (page) bench_page_machine(page, load);
    if (all || !strcmp(part, "meet")) meet_part();
    if (all || !strcmp(part, "rotation")) rotation_part();
    if (all || !strcmp(part, "pile")) pile_part();
    study_close(page, "page.md");
    return study_end();
}
