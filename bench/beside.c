/* beside.c - five scenes that bench/peers.sh runs in dem.h and in other codes, or in dem.h twice. MIT licence.

   build/beside --settle mixture       makes a start state (minutes), as build/out/beside/mixture.txt
   build/beside --codes FOLDER         writes the start states for the other codes
   build/beside --scene mixture        one line of numbers, for bench/peers.sh

   mixture     20,000 spheres of 0.5 mm and 200 of 5 mm (diameters) at rest in a closed box of 32 x 32 mm
   mesh        the drum of bench/scenes.h with each of its 240 triangles cut into 256: 61,440
   million     the bed of bench/scenes.h, 7 x 7 copies side by side: 980,000 spheres
   servo       the bed below a lid, a plane or a mesh of 200 triangles; --servo sets the motion of the lid at every step
   clumps      1000 rigid clumps of 3, 10 or 30 touching spheres (--spheres) at rest in a box

   Clumps have the linear springs of bench/blocks.c, all other scenes Hertz's law. Contacts begin without a history.
   --short takes a tenth of the bodies. Times are processor times of one thread. */
#define DEM_IMPLEMENTATION
#include "dem.h"
#include "examples/study.h"
#include "bench/measure.h"
#include "bench/scenes.h"

#define BESIDE_SMALL 0.25e-3    /* m, radii of the mixture                                      */
#define BESIDE_LARGE 2.5e-3
#define BESIDE_YOUNG 6.4e6      /* Pa, of the mixture                                           */
#define BESIDE_MIXTURE_DT 2e-6  /* s                                                            */
#define BESIDE_SPHERE 1.25e-3   /* m, radius of the spheres of a clump                          */
#define BESIDE_STIFFNESS 1e4    /* N/m, of clumps                                               */
enum { BESIDE_MOST = 30, BESIDE_TILES = 7, BESIDE_CUTS = 16, BESIDE_LID = 10 };

static const char *scene_name = "mixture", *data_folder = "bench/data", *out = "build/out/beside", *settle = "", *codes = "",
    *contacts_kind = "separate", *lid_kind = "plane";
static int steps_asked = 300, warm_asked = 100, spheres_asked = 3, servo, brief;
static double skin_asked;

typedef struct state { int count; dem_real *x, *q, *r; } state; /* m; w x y z; m                */
static state state_make(int count) {
    state s;
    s.count = count;
    s.x = (dem_real *)study_alloc((size_t)count*3, sizeof(dem_real));
    s.q = (dem_real *)study_alloc((size_t)count*4, sizeof(dem_real));
    s.r = (dem_real *)study_alloc((size_t)count, sizeof(dem_real));
    return s;
}
static void state_free(state *s) { free(s->x); free(s->q); free(s->r); }

static int bodies_of(void) { return brief ? 100 : 1000; }
static int small_of(void) { return brief ? 2000 : 20000; }
static int large_of(void) { return brief ? 20 : 200; }
static int cuts_of(void) { return brief ? 4 : BESIDE_CUTS; }
static int tiles_of(void) { return brief ? 1 : BESIDE_TILES; }
static double mixture_side(void) { return brief ? 0.016 : 0.032; }
/* m, of the box: 50 mm for 1000 clumps of 8 */
static double clumps_side(void) { return 0.05*pow(spheres_asked*bodies_of()/8000.0, 1.0/3); }

/* ---- shapes and boxes ---- */

/* Centres of the spheres of a clump about its centre of mass, in its principal axes: a triangle of 3, a tetrahedron of
   1 + 3 + 6, a pyramid of 1 + 4 + 9 + 16. moment: kg m2 */
static int clump_spheres(double *x, double moment[3]) {
    const double r = BESIDE_SPHERE, mass = 4/3.0*3.14159265358979323846*r*r*r*BENCH_DENSITY;
    const int edge = spheres_asked == 3 ? 2 : spheres_asked == 10 ? 3 : 4, flat = spheres_asked == 3;
    double mean[3] = {0, 0, 0};
    int n = 0, layer, i, j, k;
    for (layer = 0; layer < (flat ? 1 : edge); layer++)
        for (i = 0; i < edge - layer; i++)
            for (j = 0; j < edge - layer - (spheres_asked == 30 ? 0 : i); j++, n++) {
                const double skew = spheres_asked == 30 ? 0 : 0.5, up = spheres_asked == 30 ? sqrt(0.5) : sqrt(2/3.0);
                x[3*n] = 2*r*(i + skew*j + 0.5*layer);
                x[3*n + 1] = 2*r*(spheres_asked == 30 ? j + 0.5*layer : sqrt(0.75)*j + sqrt(1/12.0)*layer);
                x[3*n + 2] = 2*r*up*layer;
            }
    for (i = 0; i < n; i++) for (k = 0; k < 3; k++) mean[k] += x[3*i + k]/n;
    for (i = 0; i < n; i++) for (k = 0; k < 3; k++) x[3*i + k] -= mean[k];
    for (k = 0; k < 3; k++)
        for (moment[k] = 0, i = 0; i < n; i++) {
            const double *p = x + 3*i, d2 = p[0]*p[0] + p[1]*p[1] + p[2]*p[2] - p[k]*p[k];
            moment[k] += mass*(0.4*r*r + d2);
        }
    return n;
}
static dem_shape clump_shape(dem_world *w) {
    dem_cluster_desc c = DEM_CLUSTER_DESC;
    double x[3*BESIDE_MOST], moment[3];
    dem_real real[3*BESIDE_MOST];
    int i, n = clump_spheres(x, moment);
    for (i = 0; i < 3*n; i++) real[i] = (dem_real)x[i];
    c.count = n;
    c.positions = real;
    c.radius = (dem_real)BESIDE_SPHERE;
    c.mass = DEM_CLUSTER_SUM;           /* they touch and do not overlap                        */
    return dem_shape_cluster_add(w, &c);
}
static dem_vec3 drag_force(dem_vec3 x, dem_vec3 v, dem_real radius, dem_real mass, double time, void *user) {
    const dem_real c = -mass**(const dem_real *)user;
    (void)x; (void)radius; (void)time;
    return dem_vec3_make(c*v.x, c*v.y, c*v.z);
}
/* An open box for the mixture or for clumps. drag: 1/s, or null */
static dem_world *box_make(int clumps, dem_real *drag, dem_material *stuff) { /* drag: also a larger step, of clumps */
    const double side = clumps ? clumps_side() : mixture_side();
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc m = DEM_MATERIAL_DESC;
    dem_world *w;
    int k;
    desc.normal_law = clumps ? DEM_NORMAL_LINEAR : DEM_NORMAL_HERTZ;
    desc.gravity.z = (dem_real)-BENCH_GRAVITY;
    desc.dt = (dem_real)(!clumps ? BESIDE_MIXTURE_DT : drag ? (spheres_asked > 3 ? 1.9 : 1.2)*BENCH_DT : BENCH_DT);
    desc.skin = (dem_real)skin_asked;
    desc.threads = 1;
    if (drag) { desc.force = drag_force; desc.force_user = drag; }
    desc.cluster_contacts = strcmp(contacts_kind, "separate") ? DEM_CLUSTER_CONTACTS_MERGED : DEM_CLUSTER_CONTACTS_SEPARATE;
    w = dem_world_create(&desc);
    if (!w) { study_fail("%s", dem_world_create_error_get(&desc)); exit(1); }
    m.density = (dem_real)BENCH_DENSITY;
    m.stiffness = (dem_real)(clumps ? BESIDE_STIFFNESS : 0);
    m.stiffness_ratio = (dem_real)(clumps ? 2/7.0 : 0);
    m.young = (dem_real)(clumps ? 0 : BESIDE_YOUNG);
    m.poisson = (dem_real)BENCH_POISSON;
    m.restitution = (dem_real)(clumps ? 0.3 : BENCH_RESTITUTION);
    m.friction = (dem_real)BENCH_FRICTION;
    *stuff = dem_material_add(w, &m);
    dem_wall_plane_add(w, *stuff, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
    for (k = 0; k < 4; k++) {
        const dem_real s = (dem_real)(k & 1 ? side : 0), n = (dem_real)(k & 1 ? -1 : 1);
        dem_wall_plane_add(w, *stuff, k < 2 ? dem_vec3_make(s, 0, 0) : dem_vec3_make(0, s, 0),
                           k < 2 ? dem_vec3_make(n, 0, 0) : dem_vec3_make(0, n, 0));
    }
    return w;
}
static dem_result box_fill(dem_world *w, dem_material stuff, const state *s, int clumps) {
    return clumps ? dem_bodies_add(w, stuff, clump_shape(w), s->count, s->x, s->q, 0, 0, 0)
                  : dem_spheres_add(w, stuff, s->count, s->x, 0, s->r, 0);
}

/* ---- start states ---- */

static const char *state_name(int clumps) {
    static char text[64];
    if (clumps) snprintf(text, sizeof text, "clumps%d%s.txt", spheres_asked, brief ? "_short" : "");
    else snprintf(text, sizeof text, "mixture%s.txt", brief ? "_short" : "");
    return text;
}
/* A line a body: x y z in nm; of the mixture the radius in nm, of clumps the orientation in 1e-9. */
static void state_write(int clumps, const dem_world *w) {
    const int count = (int)dem_body_counts_get(w).present;
    FILE *file = study_open(state_name(clumps));
    int i;
    if (!file) return;
    fprintf(file, "%d\n", count);
    for (i = 0; i < count; i++) {
        dem_body_state b;
        dem_body_get(w, dem_body_id_get(w, i), &b);
        fprintf(file, "%.0f %.0f %.0f", 1e9*(double)b.position.x, 1e9*(double)b.position.y, 1e9*(double)b.position.z);
        if (clumps) fprintf(file, " %.0f %.0f %.0f %.0f\n", 1e9*(double)b.orientation.w, 1e9*(double)b.orientation.x,
                            1e9*(double)b.orientation.y, 1e9*(double)b.orientation.z);
        else fprintf(file, " %.0f\n", 1e9*(double)b.radius);
    }
    study_close(file, state_name(clumps));
}
static state state_read(int clumps) {
    char path[512];
    state s = {0, 0, 0, 0};
    double v[7];
    int i, k, n = 0;
    FILE *file;
    snprintf(path, sizeof path, "%s/%s", out, state_name(clumps));
    file = fopen(path, "r");
    if (!file || fscanf(file, "%d", &n) != 1 || n < 1 || n > 100000) {
        study_fail("cannot read %s: build/beside --settle makes it", path);
        exit(1);
    }
    s = state_make(n);
    for (i = 0; i < n; i++) {
        for (k = 0; k < (clumps ? 7 : 4); k++) if (fscanf(file, "%lf", v + k) != 1) { study_fail("%s ends early", path); exit(1); }
        for (k = 0; k < 3; k++) s.x[3*i + k] = (dem_real)(1e-9*v[k]);
        for (k = 0; k < 4 && clumps; k++) s.q[4*i + k] = (dem_real)(1e-9*v[3 + k]);
        s.r[i] = (dem_real)(1e-9*v[3]);
    }
    fclose(file);
    return s;
}
/* Large spheres fall from a lattice and small ones between them from random positions, or clumps from random ones; with
   drag at last. */
static void settle_scene(int clumps) {
    const double side = clumps ? clumps_side() : mixture_side();
    const int rows = (int)(side/(2.1*BESIDE_LARGE)), pieces = !clumps || spheres_asked == 30 ? 20 : 14, braked = clumps ? pieces - 4 : 8;
    dem_real drag = 0;
    dem_material stuff;
    dem_world *w = box_make(clumps, &drag, &stuff);
    const dem_real s = (dem_real)side;
    uint64_t seed = 11;
    int i, k, n = 0, wanted;
    dem_totals t;
    if (clumps) {
        wanted = bodies_of();
        n = dem_bodies_fill(w, stuff, clump_shape(w), dem_region_make(dem_box_make(0, 0, 0, s, s, (dem_real)(14*side))), wanted, 3);
    } else {
        const double gap = side/rows;
        wanted = small_of() + large_of();
        for (i = 0; i < large_of(); i++) {
            double x[3];
            for (k = 0; k < 3; k++)
                x[k] = ((k == 0 ? i%rows : k == 1 ? i/rows%rows : i/(rows*rows)) + 0.5)*gap +
                       0.8*(gap/2 - BESIDE_LARGE)*(2*(double)demi_uniform(&seed) - 1);
            n += dem_sphere_add(w, stuff, (dem_real)BESIDE_LARGE, dem_vec3_make((dem_real)x[0], (dem_real)x[1], (dem_real)x[2])).slot != 0;
        }
        n += dem_spheres_fill(w, stuff, (dem_real)BESIDE_SMALL,
                              dem_region_make(dem_box_make(0, 0, 0, s, s, (dem_real)(0.45*side))), small_of(), 5);
    }
    if (n != wanted) { study_fail("%d of %d bodies found room: %s", n, wanted, dem_world_error_get(w)); return; }
    for (i = 1; i <= pieces; i++) {
        if (i == braked) drag = clumps ? 100 : 200;
        if (dem_world_run(w, clumps ? 0.04 : brief ? 0.004 : 0.007, 0, 0) != DEM_OK) { study_fail("%s", dem_world_error_get(w)); return; }
        study_progress("bodies come to rest", i/(double)pieces, wanted*(double)dem_counters_get(w).steps);
    }
    t = dem_totals_get(w);
    state_write(clumps, w);
    study_result("kinetic", t.kinetic + t.rotational, "J");
    study_result("height", t.centre[2], "m");
    study_result("contacts", dem_counters_get(w).contacts/(double)n, "");
    dem_world_destroy(w);
}

/* ---- for the other codes ---- */

static FILE *code_file(const char *name) {
    char path[512];
    FILE *file;
    snprintf(path, sizeof path, "%s/%s", codes, name);
    file = fopen(path, "w");
    if (!file) { study_fail("cannot write %s: %s", path, strerror(errno)); exit(1); }
    return file;
}
/* The mixture as LAMMPS reads it: type 1 small, type 2 large. */
static void mixture_for_codes(void) {
    state s = state_read(0);
    FILE *file = code_file("mixture.data");
    const double side = mixture_side();
    int i;
    fprintf(file, "mixture\n\n%d atoms\n2 atom types\n\n-0.001 %g xlo xhi\n-0.001 %g ylo yhi\n-0.001 %g zlo zhi\n\nAtoms\n\n",
            s.count, side + 0.001, side + 0.001, 2*side);
    for (i = 0; i < s.count; i++)
        fprintf(file, "%d %d %.12g %.12g %.12g %.12g %.12g\n", i + 1, (double)s.r[i] > 1e-3 ? 2 : 1, 2*(double)s.r[i],
                BENCH_DENSITY, (double)s.x[3*i], (double)s.x[3*i + 1], (double)s.x[3*i + 2]);
    fclose(file);
    state_free(&s);
}
/* A template a clump, since a template of LIGGGHTS has one orientation. */
static void clumps_for_codes(void) {
    state s = state_read(1);
    double x[3*BESIDE_MOST], moment[3];
    const double r = BESIDE_SPHERE, one = 4/3.0*3.14159265358979323846*r*r*r*BENCH_DENSITY;
    const int n = clump_spheres(x, moment);
    char name[64];
    FILE *file;
    int i, j, k, a, b;
    snprintf(name, sizeof name, "clumps%d.put", spheres_asked);
    file = code_file(name);
    for (i = 0; i < s.count; i++) {
        const dem_quat turn = demi_quat_again(dem_quat_make(s.q[4*i], s.q[4*i + 1], s.q[4*i + 2], s.q[4*i + 3]));
        double tensor[3][3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
        for (k = 0; k < 3; k++) {
            const dem_vec3 e = dem_quat_rotate(turn, dem_vec3_make(k == 0, k == 1, k == 2));
            const double axis[3] = {(double)e.x, (double)e.y, (double)e.z};
            for (a = 0; a < 3; a++) for (b = 0; b < 3; b++) tensor[a][b] += moment[k]*axis[a]*axis[b];
        }
        fprintf(file, "region here block");
        for (k = 0; k < 3; k++) fprintf(file, " %.12g %.12g", (double)s.x[3*i + k] - 1e-12, (double)s.x[3*i + k] + 1e-12);
        fprintf(file, " units box volume_limit 1e-40\nfix kind all particletemplate/multisphere 15485863 atom_type 1 "
                "density constant %g nspheres %d ntry 1000 spheres", BENCH_DENSITY, n);
        for (j = 0; j < n; j++) {
            const dem_vec3 at = dem_quat_rotate(turn, dem_vec3_make((dem_real)x[3*j], (dem_real)x[3*j + 1], (dem_real)x[3*j + 2]));
            fprintf(file, " %.12g %.12g %.12g %.12g", (double)at.x, (double)at.y, (double)at.z, r);
        }
        fprintf(file, " type 1 mass %.12g inertia_tensor %.12g %.12g %.12g %.12g %.12g %.12g use_density\n", n*one, tensor[0][0],
                tensor[0][1], tensor[0][2], tensor[1][1], tensor[1][2], tensor[2][2]);
        fprintf(file, "fix kinds all particledistribution/discrete 15485867 1 kind 1\n"
                "fix put all insert/pack seed 32452843 distributiontemplate kinds verbose no insert_every once overlapcheck no "
                "orientation template region here particles_in_region 1\n"
                "run 1\nunfix put\nunfix kinds\nunfix kind\nregion here delete\n");
    }
    fclose(file);
    state_free(&s);
}
/* The drum's mesh with each side of its triangles cut, as bench_drum_walls does. */
static void mesh_for_codes(void) {
    static double p[9*BENCH_DRUM_TRIANGLES];
    const int n = cuts_of();
    FILE *file = code_file("mesh.stl");
    int t, i, j, up, k, e;
    bench_drum_mesh(BENCH_DRUM_ANGLE, p);
    fprintf(file, "solid drum\n");
    for (t = 0; t < BENCH_DRUM_TRIANGLES; t++)
        for (i = 0; i < n; i++) for (j = 0; j < n - i; j++) for (up = 0; up < (j < n - i - 1 ? 2 : 1); up++) {
            fprintf(file, "facet normal 0 0 0\n outer loop\n");
            for (k = 0; k < 3; k++) {
                const int u = i + (up ? k != 2 : k == 1), v = j + (up ? k != 0 : k == 2);
                const double *a = p + 9*t;
                fprintf(file, "  vertex");
                for (e = 0; e < 3; e++) fprintf(file, " %.12g", a[e] + (a[3 + e] - a[e])*u/n + (a[6 + e] - a[e])*v/n);
                fprintf(file, "\n");
            }
            fprintf(file, " endloop\nendfacet\n");
        }
    fprintf(file, "endsolid drum\n");
    fclose(file);
}

/* ---- measuring ---- */

/* The bed, 7 x 7 times. */
static dem_world *million_make(void) {
    const int tiles = tiles_of();
    bench_choice choice = {0};
    bench_scene bed = bench_scene_read(data_folder, "bed"), all = bench_scene_make("bed", bed.count*tiles*tiles);
    dem_world *w;
    int i, n = 0, a, b;
    for (a = 0; a < tiles; a++) for (b = 0; b < tiles; b++) for (i = 0; i < bed.count; i++, n++) {
        all.x[3*n] = bed.x[3*i] + a*bed.side[0];
        all.x[3*n + 1] = bed.x[3*i + 1] + b*bed.side[1];
        all.x[3*n + 2] = bed.x[3*i + 2];
    }
    all.side[0] *= tiles;
    all.side[1] *= tiles;
    choice.skin = skin_asked;
    w = bench_world(&all, &choice);
    bench_scene_free(&bed);
    bench_scene_free(&all);
    return w;
}
/* The bed below a lid that touches its highest bead. */
static dem_world *servo_make(dem_wall *lid) {
    bench_choice choice = {0};
    bench_scene bed = bench_scene_read(data_folder, "bed");
    dem_world *w = bench_world(&bed, &choice);
    dem_body_state first;
    double top = 0;
    int i, j, e, k = 0;
    if (!w) return 0;
    dem_body_get(w, dem_body_id_get(w, 0), &first);
    for (i = 0; i < bed.count; i++) top = fmax(top, bed.x[3*i + 2] + bed.radius);
    if (!strcmp(lid_kind, "plane"))
        *lid = dem_wall_plane_add(w, first.material, dem_vec3_make(0, 0, (dem_real)top), dem_vec3_make(0, 0, -1));
    else {
        dem_real x[3*(BESIDE_LID + 1)*(BESIDE_LID + 1)];
        int32_t corner[6*BESIDE_LID*BESIDE_LID];
        dem_mesh mesh;
        mesh.vertex_count = (BESIDE_LID + 1)*(BESIDE_LID + 1);
        mesh.triangle_count = 2*BESIDE_LID*BESIDE_LID;
        mesh.vertices = x;
        mesh.triangles = corner;
        for (j = 0; j <= BESIDE_LID; j++) for (i = 0; i <= BESIDE_LID; i++) {
            dem_real *p = x + 3*(i + (BESIDE_LID + 1)*j);
            p[0] = (dem_real)(0.005 + 0.08*i/BESIDE_LID);
            p[1] = (dem_real)(0.005 + 0.08*j/BESIDE_LID);
            p[2] = (dem_real)top;
        }
        for (j = 0; j < BESIDE_LID; j++) for (i = 0; i < BESIDE_LID; i++) {
            const int32_t a = i + (BESIDE_LID + 1)*j, c = a + BESIDE_LID + 1, six[6] = {a, a + 1, c + 1, a, c + 1, c};
            for (e = 0; e < 6; e++) corner[k++] = six[e];
        }
        *lid = dem_wall_mesh_add(w, first.material, &mesh);
    }
    bench_scene_free(&bed);
    return w;
}
/* Steps, one at a time where there is a lid; a servo moves it towards a load of 0.1 N. */
static dem_result steps_do(dem_world *w, dem_wall lid, int steps) {
    dem_result result = DEM_OK;
    int i;
    if (!lid.id) return dem_world_step(w, steps);
    for (i = 0; i < steps && result == DEM_OK; i++) {
        if (servo) {
            dem_motion motion = DEM_MOTION;
            dem_wall_loads loads;
            memset(&loads, 0, sizeof loads);
            dem_wall_loads_get(w, lid, &loads);
            motion.kind = DEM_MOTION_TRANSLATING;
            motion.velocity.z = (dem_real)(0.001*((double)loads.force.z - 0.1));
            result = dem_wall_motion_set(w, lid, &motion);
        }
        if (result == DEM_OK) result = dem_world_step(w, 1);
    }
    return result;
}
/* m, mean overlap of contacts between bodies. */
static double overlap_mean(const dem_world *w) {
    const int n = dem_contacts_get(w, 0, 0);
    dem_contact_info *all = n > 0 ? (dem_contact_info *)study_alloc((size_t)n, sizeof *all) : 0;
    double sum = 0;
    int i, count = 0;
    if (!all) return 0;
    dem_contacts_get(w, all, n);
    for (i = 0; i < n; i++) if (!all[i].wall && all[i].overlap > 0) { sum += (double)all[i].overlap; count++; }
    free(all);
    return count ? sum/count : 0;
}
/* One line: s of processor time, contacts of bodies per body, J, bytes per body, m by which the centre sank, m of overlap,
   bodies, rebuilds of the list per step. */
static void measure(void) {
    const int clumps = !strcmp(scene_name, "clumps"), mixture = !strcmp(scene_name, "mixture");
    dem_wall lid = {0};
    dem_world *w = 0;
    dem_counters c;
    dem_totals t;
    double high, count;
    uint64_t before;
    clock_t begun, ended;
    if (clumps || mixture) {
        state s = state_read(clumps);
        dem_material stuff;
        w = box_make(clumps, 0, &stuff);
        if (box_fill(w, stuff, &s, clumps) != DEM_OK) { study_fail("%s", dem_world_error_get(w)); return; }
        state_free(&s);
    } else if (!strcmp(scene_name, "million")) w = million_make();
    else if (!strcmp(scene_name, "servo")) w = servo_make(&lid);
    else {
        bench_choice choice = {0};
        bench_scene drum = bench_scene_read(data_folder, "drum");
        choice.cuts = cuts_of();
        choice.skin = skin_asked;
        w = bench_world(&drum, &choice);
        bench_scene_free(&drum);
    }
    if (!w) return;
    high = dem_totals_get(w).centre[2];
    if (steps_do(w, lid, warm_asked) != DEM_OK) { study_fail("%s", dem_world_error_get(w)); return; }
    before = dem_counters_get(w).rebuilds;
    begun = clock();
    if (steps_do(w, lid, steps_asked) != DEM_OK) { study_fail("%s", dem_world_error_get(w)); return; }
    ended = clock();
    c = dem_counters_get(w);
    t = dem_totals_get(w);
    count = (double)dem_body_counts_get(w).present;
    printf("raw %.6f %.5f %.6g %.0f %.6g %.6g %.0f %.4f\n", (double)(ended - begun)/CLOCKS_PER_SEC,
           (clumps ? 1 : 2)*c.contacts/count, t.kinetic, (double)c.memory/count, high - t.centre[2], overlap_mean(w), count,
           (double)(c.rebuilds - before)/steps_asked);
    dem_world_destroy(w);
}

int main(int argc, char **argv) {
    static const study_option table[] = {
        {"scene", STUDY_CHOICE, &scene_name, 0, 0, "mixture|mesh|million|servo|clumps", "what to measure"},
        {"steps", STUDY_INT, &steps_asked, 1, 1e8, "", "timed steps"},
        {"warm", STUDY_INT, &warm_asked, 1, 1e8, "", "steps before them"},
        {"spheres", STUDY_INT, &spheres_asked, 3, BESIDE_MOST, "", "of a clump: 3, 10 or 30"},
        {"contacts", STUDY_CHOICE, &contacts_kind, 0, 0, "separate|merged", "contacts of clumps (cluster_contacts)"},
        {"lid", STUDY_CHOICE, &lid_kind, 0, 0, "plane|mesh", "of servo"},
        {"servo", STUDY_FLAG, &servo, 0, 0, "", "set the motion of the lid at every step; otherwise it is at rest"},
        {"skin", STUDY_REAL, &skin_asked, 0, 1, "m", "margin of the list, 0: chosen"},
        {"short", STUDY_FLAG, &brief, 0, 0, "", "a tenth of the bodies"},
        {"data", STUDY_TEXT, &data_folder, 0, 0, "", "folder of start states of bed and drum"},
        {"out", STUDY_TEXT, &out, 0, 0, "", "folder of start states made here"},
        {"settle", STUDY_CHOICE, &settle, 0, 0, "mixture|clumps", "make a start state"},
        {"codes", STUDY_TEXT, &codes, 0, 0, "", "write the scene for other codes into this folder"},
    };
    study_options(argc, argv, "Scenes beside other codes.", table, (int)(sizeof table/sizeof *table));
    if (spheres_asked != 3 && spheres_asked != 10 && spheres_asked != 30) { study_fail("--spheres is 3, 10 or 30"); return 2; }
    if (*settle) {
        study_begin(out);
        bench_machine();
        settle_scene(!strcmp(settle, "clumps"));
        return study_end();
    }
    if (*codes) {
        study_make_folder(codes);
        if (!strcmp(scene_name, "clumps")) clumps_for_codes();
        else if (!strcmp(scene_name, "mesh")) mesh_for_codes();
        else if (!strcmp(scene_name, "mixture")) mixture_for_codes();
        return study.failures != 0;
    }
    measure();
    return study.failures != 0;
}
