/* scenes.h - the three scenes of the benches. MIT licence.

   BED    20,000 glass beads at rest in a layer of 40 diameters, periodic sideways, on a floor
   DRUM   18,000 beads in a drum with eight lifters (240 triangles) that turns at 0.7 of critical
   GAS    32,768 frictionless spheres in a periodic cube, 5.8 % of it solid

   Start states are files of integers in bench/data/: one line that says how many and what unit,
   then one line a bead. Other codes get the same numbers, see bench/peers.sh.

   Needs dem.h and examples/study.h before it. A scene in short:

       bench_scene bed = bench_scene_read("bench/data", "bed");
       bench_choice choice = BENCH_CHOICE;            // what differs from the library's choices
       dem_world *world = bench_world(&bed, &choice); // null when refused; why is on stderr
*/
#ifndef BENCH_SCENES_H
#define BENCH_SCENES_H

/* Beads of BED and DRUM. */
#define BENCH_RADIUS 1.5e-3     /* m                                                           */
#define BENCH_DENSITY 2500.0    /* kg/m3, of all three                                         */
#define BENCH_YOUNG 6.4e7       /* Pa                                                          */
#define BENCH_POISSON 0.23
#define BENCH_RESTITUTION 0.66
#define BENCH_FRICTION 0.5
#define BENCH_GRAVITY 9.81      /* m/s2, along -z                                              */
#define BENCH_DT 5e-6           /* s                                                           */
/* BED */
#define BENCH_BED_SIDE 0.09     /* m, periodic in x and y; the floor is z = 0                  */
#define BENCH_BED_HEIGHT 0.12   /* m, of the box that other codes ask for                      */
/* DRUM: axis y, end plates at y = 0 and DRUM_LENGTH */
#define BENCH_DRUM_RADIUS 0.075 /* m                                                           */
#define BENCH_DRUM_LENGTH 0.06  /* m                                                           */
#define BENCH_DRUM_SPEED 8.005747935           /* rad/s about +y: 0.7 sqrt(g/R)                */
#define BENCH_DRUM_ANGLE 138.52606170286936    /* degrees turned when the state was stored     */
#define BENCH_DRUM_BARS 8
#define BENCH_DRUM_FACETS 96
/* GAS: F = kn overlap - m_eff gamma v; e = exp(-gamma t_c/2) = 0.95, t_c = 4e-4 s */
#define BENCH_GAS_RADIUS 0.015  /* m                                                           */
#define BENCH_GAS_SIDE 1.9989170665030904      /* m, periodic                                  */
#define BENCH_GAS_STIFFNESS 1.090355e6         /* N/m                                          */
#define BENCH_GAS_DAMPING 256.46647            /* 1/s, gamma                                   */
#define BENCH_GAS_RESTITUTION 0.95
#define BENCH_GAS_DT 8e-6       /* s                                                           */

typedef struct bench_scene {
    char name[16];              /* bed, drum, gas                                              */
    int count;
    double radius, dt;          /* m, s                                                        */
    double side[3];             /* m, periodic along BED's x and y and GAS's x, y and z; else 0 */
    double *x, *v, *spin;       /* count x 3: m, m/s, rad/s                                    */
} bench_scene;

/* What differs from the defaults; zero is the default. */
typedef struct bench_choice {
    int threads;                /* 0: one                                                      */
    double skin;                /* as in dem_world_desc                                        */
    int ledger;                 /* 1: energy balance; 2: contacts are recorded, too             */
    dem_normal_law normal;
    dem_tangent_law tangent;
    dem_rolling_law rolling;
    dem_integrator integrator;
    dem_search search;
    int mixed;                  /* 1: one bead is 0.1 % smaller; 2: every second one; 3: all, each a little differently */
    double rolling_friction;
    int every;                  /* 0 or 1: all beads; n: every n-th                            */
    double dt;                  /* s, 0: the scene's                                           */
    dem_force_fn force;
    void *force_user;
    double feed;                /* beads/s fed into the middle of DRUM, 0: none                 */
    int outlet;                 /* 1: beads that fly through the middle of DRUM leave; 2: far off */
    int smooth;                 /* 1: no friction in any pair, whatever the laws                */
    int orientations;           /* as in dem_world_desc                                         */
    int adhesion;               /* 1: hysteretic law that unloads as steeply as it loads; 2: and sticks */
    int field;                  /* 1: solidicity and velocity sampled every 100 steps; 2: never again */
    int open;                   /* 1: no boundary is periodic                                   */
    int shaped;                 /* beads given as 1: ellipsoids of three equal axes; 2: clusters of one sphere; 3: the same,
                                   its centre of mass 1e-6 radii off; 4: spheres, except the last, a cluster as in 3 */
    int cuts;                   /* parts of each side of DRUM's triangles: cuts^2 triangles each; 0 or 1: one */
    dem_law_fn law;             /* a user-defined law: 3 reals, 1 vector                        */
    dem_law_rows_fn rows;       /* the same for rows of contacts                                */
    double range;               /* its range, in radii                                          */
    int who;                    /* 1: it asks who touches                                       */
    int reals;                  /* 1: grains carry a number                                     */
    int lid;                    /* BED is pressed by a plane: 1: at rest after that; 2: the servo goes on */
} bench_choice;
enum { BENCH_LID_STEPS = 8000 };
#define BENCH_CHOICE {.normal = DEM_NORMAL_HERTZ, .tangent = DEM_TANGENT_AUTO, .rolling = DEM_ROLLING_AUTO, \
    .integrator = DEM_INTEGRATOR_VELOCITY_VERLET, .search = DEM_SEARCH_AUTO}

STUDY_FN int bench_is(const bench_scene *s, const char *name) { return !strcmp(s->name, name); }

/* ---- start states ---- */

/* Metres, m/s and rad/s of one unit of a file; 0: the file does not have it. */
STUDY_FN void bench_units(const char *name, double unit[3]) {
    const int drum = !strcmp(name, "drum"), gas = !strcmp(name, "gas");
    unit[0] = gas ? 1e-6 : drum ? 1e-8 : 1e-9;  /* far below an overlap */
    unit[1] = gas || drum ? 1e-4 : 0;
    unit[2] = drum ? 1e-2 : 0;
}

STUDY_FN bench_scene bench_scene_make(const char *name, int count) {
    bench_scene s;
    memset(&s, 0, sizeof s);
    snprintf(s.name, sizeof s.name, "%s", name);
    s.count = count;
    s.radius = !strcmp(name, "gas") ? BENCH_GAS_RADIUS : BENCH_RADIUS;
    s.dt = !strcmp(name, "gas") ? BENCH_GAS_DT : BENCH_DT;
    if (!strcmp(name, "bed")) s.side[0] = s.side[1] = BENCH_BED_SIDE;
    if (!strcmp(name, "gas")) s.side[0] = s.side[1] = s.side[2] = BENCH_GAS_SIDE;
    s.x = (double *)study_alloc((size_t)count*3, sizeof(double));
    s.v = (double *)study_alloc((size_t)count*3, sizeof(double));
    s.spin = (double *)study_alloc((size_t)count*3, sizeof(double));
    return s;
}
STUDY_FN void bench_scene_free(bench_scene *s) {
    free(s->x); free(s->v); free(s->spin);
    memset(s, 0, sizeof *s);
}

/* bed_20k.txt, drum_18k.txt or gas_32k.txt from a folder. Ends the program when it cannot. */
STUDY_FN const char *bench_file(const char *name) {
    return !strcmp(name, "bed") ? "bed_20k.txt" : !strcmp(name, "drum") ? "drum_18k.txt" : "gas_32k.txt";
}
STUDY_FN bench_scene bench_scene_read(const char *folder, const char *name) {
    char path[512], line[256], word[16];
    double unit[3];
    int count = 0, columns = 0, i, k, c;
    bench_scene s;
    FILE *file;
    snprintf(path, sizeof path, "%s/%s", folder, bench_file(name));
    file = fopen(path, "r");
    if (!file) {
        study_fail("cannot read %s: %s; run from the project's folder, or say --data FOLDER", path,
                   strerror(errno));
        exit(1);
    }
    if (!fgets(line, sizeof line, file) || sscanf(line, "%15s %d %d", word, &count, &columns) != 3 ||
        strcmp(word, name) || count < 1 || count > 100000000 || columns%3 || columns < 3 || columns > 9) {
        study_fail("%s: the first line is not '%s COUNT COLUMNS columns: ...'", path, name);
        exit(1);
    }
    bench_units(name, unit);
    s = bench_scene_make(name, count);
    for (i = 0; i < count; i++)
        for (k = 0; k < columns/3; k++) {
            double *to = (k == 0 ? s.x : k == 1 ? s.v : s.spin) + 3*i;
            for (c = 0; c < 3; c++) {
                long value;
                if (fscanf(file, "%ld", &value) != 1) {
                    study_fail("%s: line %d is not %d whole numbers", path, i + 2, columns);
                    exit(1);
                }
                to[c] = unit[k]*(double)value;
            }
        }
    fclose(file);
    return s;
}

/* Writes what bench_scene_read reads. */
STUDY_FN void bench_scene_write(const bench_scene *s, const char *path) {
    double unit[3];
    FILE *file = fopen(path, "w");
    int i, k, c, kinds;
    if (!file) { study_fail("cannot write %s: %s", path, strerror(errno)); return; }
    bench_units(s->name, unit);
    kinds = 1 + (unit[1] > 0) + (unit[2] > 0);
    fprintf(file, "%s %d %d columns: x y z in %s%s%s\n", s->name, s->count, 3*kinds,
            unit[0] > 5e-7 ? "um" : unit[0] > 5e-9 ? "10 nm" : "nm",
            kinds > 1 ? ", velocity in 0.1 mm/s" : "", kinds > 2 ? ", spin in 0.01 rad/s" : "");
    for (i = 0; i < s->count; i++)
        for (k = 0; k < kinds; k++)
            for (c = 0; c < 3; c++)
                fprintf(file, "%.0f%c", floor((k == 0 ? s->x : k == 1 ? s->v : s->spin)[3*i + c]/unit[k] + 0.5),
                        k + 1 == kinds && c == 2 ? '\n' : ' ');
    if (fclose(file)) study_fail("%s was not written in full: is the disk full?", path);
}

/* Positions, velocities and spins of a world, in the order in which its bodies were added; periodic
   positions brought back into the box. */
STUDY_FN void bench_scene_take(bench_scene *s, const dem_world *world) {
    const dem_bodies b = dem_bodies_get(world);
    int i, c;
    for (i = 0; i < b.count; i++) {
        const size_t to = 3*(size_t)(dem_body_id_get(world, i).slot - 1);
        for (c = 0; c < 3; c++) {
            s->x[to + (size_t)c] = (double)b.positions[4*i + c];
            s->v[to + (size_t)c] = (double)b.velocities[4*i + c];
            s->spin[to + (size_t)c] = (double)b.spins[4*i + c];
            if (s->side[c] > 0) s->x[to + (size_t)c] -= s->side[c]*floor(s->x[to + (size_t)c]/s->side[c]);
        }
    }
}

/* ---- the drum's mesh ---- */

/* A shell of 96 facets and eight bars 8 mm high, 6 mm wide, one of them at +x; turned by degrees about
   +y. 240 triangles, 9 numbers each; stands 1 mm out of both end plates. */
enum { BENCH_DRUM_TRIANGLES = 2*BENCH_DRUM_FACETS + 6*BENCH_DRUM_BARS };
STUDY_FN void bench_drum_mesh(double degrees, double *corners) {
    const double foot = 0.0748998521791, top = 0.067, half = 0.003; /* m: a bar's cross section  */
    const double bar[4][2] = {{foot, -half}, {top, -half}, {top, half}, {foot, half}};
    const double pi = 3.14159265358979323846, c = cos(degrees*pi/180), s = sin(degrees*pi/180);
    const double y[2] = {-0.001, BENCH_DRUM_LENGTH + 0.001};
    const int first[3][2] = {{0, 0}, {1, 0}, {1, 1}}, second[3][2] = {{0, 0}, {1, 1}, {0, 1}};
    int piece, k, t = 0;
    for (piece = 0; piece < BENCH_DRUM_FACETS + 3*BENCH_DRUM_BARS; piece++) {
        double end[2][2], turned[2][2]; /* x, z of the strip's two ends                           */
        for (k = 0; k < 2; k++) {
            const int b = piece - BENCH_DRUM_FACETS;
            if (b < 0) {
                const double angle = 2*pi*(piece + k)/BENCH_DRUM_FACETS;
                end[k][0] = BENCH_DRUM_RADIUS*cos(angle);
                end[k][1] = BENCH_DRUM_RADIUS*sin(angle);
            } else {
                const double angle = 2*pi*(b/3)/BENCH_DRUM_BARS, *p = bar[b%3 + k];
                end[k][0] = p[0]*cos(angle) - p[1]*sin(angle);
                end[k][1] = p[0]*sin(angle) + p[1]*cos(angle);
            }
            turned[k][0] = c*end[k][0] + s*end[k][1];   /* right-handed about +y: z goes to x     */
            turned[k][1] = c*end[k][1] - s*end[k][0];
        }
        for (k = 0; k < 6; k++, t++) {
            const int *at = k < 3 ? first[k] : second[k - 3];
            corners[3*t] = turned[at[0]][0];
            corners[3*t + 1] = y[at[1]];
            corners[3*t + 2] = turned[at[0]][1];
        }
    }
}

/* The same as text STL, for other codes. */
STUDY_FN void bench_drum_stl(const char *path, double degrees) {
    double *p = (double *)study_alloc(9*BENCH_DRUM_TRIANGLES, sizeof(double));
    FILE *file = fopen(path, "w");
    int t, k;
    if (!file) { study_fail("cannot write %s: %s", path, strerror(errno)); free(p); return; }
    bench_drum_mesh(degrees, p);
    fprintf(file, "solid drum\n");
    for (t = 0; t < BENCH_DRUM_TRIANGLES; t++) {
        const double *a = p + 9*t, ux = a[3] - a[0], uy = a[4] - a[1], uz = a[5] - a[2];
        const double vx = a[6] - a[0], vy = a[7] - a[1], vz = a[8] - a[2];
        const double nx = uy*vz - uz*vy, ny = uz*vx - ux*vz, nz = ux*vy - uy*vx;
        const double n = sqrt(nx*nx + ny*ny + nz*nz);
        fprintf(file, "facet normal %.9g %.9g %.9g\n outer loop\n", nx/n, ny/n, nz/n);
        for (k = 0; k < 3; k++) fprintf(file, "  vertex %.12g %.12g %.12g\n", a[3*k], a[3*k + 1], a[3*k + 2]);
        fprintf(file, " endloop\nendfacet\n");
    }
    fprintf(file, "endsolid drum\n");
    if (fclose(file)) study_fail("%s was not written in full: is the disk full?", path);
    free(p);
}

/* ---- worlds ---- */

STUDY_FN int bench_drum_walls(dem_world *world, dem_material glass, double degrees, int cuts) {
    const int n = cuts > 1 ? cuts : 1, count = BENCH_DRUM_TRIANGLES*n*n;
    double *p = (double *)study_alloc(9*BENCH_DRUM_TRIANGLES, sizeof(double));
    dem_mesh mesh;
    dem_motion turning = DEM_MOTION;
    dem_wall drum;
    int t, i, j, up, k, e, at = 0, ok;
    bench_drum_mesh(degrees, p);
    mesh.vertex_count = 3*count;
    mesh.triangle_count = count;
    mesh.vertices = (dem_real *)study_alloc((size_t)9*(size_t)count, sizeof(dem_real));
    mesh.triangles = (int32_t *)study_alloc((size_t)3*(size_t)count, sizeof(int32_t));
    for (t = 0; t < BENCH_DRUM_TRIANGLES; t++)
        for (i = 0; i < n; i++) for (j = 0; j < n - i; j++) for (up = 0; up < (j < n - i - 1 ? 2 : 1); up++)
            for (k = 0; k < 3; k++) {           /* corner a + u (b - a) + v (c - a) */
                const int u = i + (up ? k != 2 : k == 1), v = j + (up ? k != 0 : k == 2);
                const double *a = p + 9*t;
                for (e = 0; e < 3; e++)
                    mesh.vertices[at++] = (dem_real)(n == 1 ? a[3*k + e] : a[e] + (a[3 + e] - a[e])*u/n + (a[6 + e] - a[e])*v/n);
            }
    for (k = 0; k < 3*count; k++) mesh.triangles[k] = k;
    drum = dem_wall_mesh_add(world, glass, &mesh);
    turning.kind = DEM_MOTION_ROTATING;
    turning.axis = dem_vec3_make(0, 1, 0);
    turning.speed = (dem_real)BENCH_DRUM_SPEED;
    ok = drum.id && dem_wall_motion_set(world, drum, &turning) == DEM_OK &&
         dem_wall_plane_add(world, glass, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 1, 0)).id &&
         dem_wall_plane_add(world, glass, dem_vec3_make(0, (dem_real)BENCH_DRUM_LENGTH, 0),
                       dem_vec3_make(0, -1, 0)).id;
    free(mesh.vertices); free(mesh.triangles); free(p);
    return ok;
}

/* What comes in and goes out in the middle of DRUM. */
STUDY_FN int bench_drum_flow(dem_world *world, dem_material glass, const bench_choice *o) {
    const dem_box middle = dem_box_make(DEM_R(-0.02), DEM_R(0.005), DEM_R(-0.02), DEM_R(0.02), DEM_R(0.055),
                                        DEM_R(0.02));
    dem_feed_desc feed;
    dem_outlet_desc outlet;
    memset(&feed, 0, sizeof feed);
    memset(&outlet, 0, sizeof outlet);
    feed.material = glass;
    feed.class_count = 1;
    feed.radius[0] = (dem_real)BENCH_RADIUS;
    feed.amount[0] = 1;
    feed.rate = o->feed;
    feed.box = middle;
    feed.velocity = dem_vec3_make(0, 0, -1);
    outlet.box = middle;
    if (o->outlet == 2) { outlet.box.lo.z += 10; outlet.box.hi.z += 10; }
    return (!(o->feed > 0) || dem_feed_add(world, &feed).id) && (!o->outlet || dem_outlet_add(world, &outlet).id);
}

/* A field over BED, of cells four radii wide. */
STUDY_FN int bench_field(dem_world *world, const bench_scene *s, const bench_choice *o) {
    dem_field_desc field;
    memset(&field, 0, sizeof field);
    if (!o->field) return 1;
    field.box = dem_box_make(0, 0, 0, (dem_real)s->side[0], (dem_real)s->side[1], (dem_real)BENCH_BED_HEIGHT);
    field.cells[0] = (int)(s->side[0]/(4*s->radius));
    field.cells[1] = (int)(s->side[1]/(4*s->radius));
    field.cells[2] = (int)(BENCH_BED_HEIGHT/(4*s->radius));
    field.interval = 100*s->dt;
    field.end = o->field == 2 ? s->dt : 0;
    return dem_field_add(world, &field).id != 0;
}
/* A bead as a shape: what goes the way of bodies that are not spheres, at the places spheres have. */
STUDY_FN dem_shape bench_shape(dem_world *world, int shaped, dem_real radius) {
    static const dem_real centre[3] = {0, 0, 0};
    dem_cluster_desc one = DEM_CLUSTER_DESC;
    one.count = 1;
    one.positions = centre;
    one.radius = radius;
    if (shaped > 2) {
        const dem_real volume = (dem_real)4.18879*radius*radius*radius;
        one.mass = DEM_CLUSTER_GIVEN;
        one.volume = volume;
        one.centre = dem_vec3_make(radius*(dem_real)1e-6, 0, 0);
        one.inertia[0] = one.inertia[1] = one.inertia[2] = (dem_real)0.4*volume*radius*radius;
    }
    return shaped == 1 ? dem_shape_ellipsoid_add(world, dem_vec3_make(radius, radius, radius))
                       : dem_shape_cluster_add(world, &one);
}
/* By how much of the radius bead i is smaller; where all are, too little to change the scene. */
STUDY_FN double bench_smaller(int mixed, int i) {
    if (mixed == 3) return 1e-6*(i*7919%10007)/10007;
    return (mixed == 1 && !i) || (mixed == 2 && i%2) ? 1e-3 : 0;
}
/* The world of a scene at its start state. degrees: how far DRUM has turned. */
STUDY_FN dem_world *bench_world_at(const bench_scene *s, const bench_choice *o, double degrees) {
    const int gas = bench_is(s, "gas"), bed = bench_is(s, "bed"), drum = bench_is(s, "drum");
    const int every = o->every > 1 ? o->every : 1, count = (s->count + every - 1)/every;
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc m = DEM_MATERIAL_DESC;
    dem_material material;
    dem_shape shape = {0};
    dem_pair pair;
    dem_world *world;
    dem_real *x, *v, *r;
    dem_result result;
    int i, c, balls, ok = 1;
    desc.threads = o->threads > 0 ? o->threads : 1;
    desc.skin = (dem_real)o->skin;
    desc.ledger = o->ledger > 0;
    desc.integrator = o->integrator;
    desc.search = o->search;
    desc.normal_law = gas ? DEM_NORMAL_LINEAR : o->adhesion ? DEM_NORMAL_HYSTERETIC : o->normal;
    desc.orientations = o->orientations;
    desc.tangent_law = o->tangent;
    desc.rolling_law = o->rolling;
    desc.law = o->law;
    desc.law_rows = o->rows;
    desc.law_memory = o->law ? 3 : 0;
    desc.law_vectors = o->law ? 1 : 0;
    desc.law_range = (dem_real)(o->range*s->radius);
    desc.law_who = o->who;
    desc.body_reals = o->reals ? "temperature" : 0;
    desc.force = o->force;
    desc.force_user = o->force_user;
    desc.dt = (dem_real)(o->dt > 0 ? o->dt : s->dt);
    if (!gas) desc.gravity.z = (dem_real)-BENCH_GRAVITY;
    if (!gas && (o->normal == DEM_NORMAL_LINEAR || o->adhesion)) desc.impact_speed = DEM_R(0.03); /* as stiff as the bed's contacts */
    if (bed) {
        desc.boundary[0] = desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
        desc.domain = dem_box_make(0, 0, 0, (dem_real)s->side[0], (dem_real)s->side[1],
                                   (dem_real)BENCH_BED_HEIGHT);
    }
    if (gas) {
        const dem_real L = (dem_real)BENCH_GAS_SIDE;
        desc.boundary[0] = desc.boundary[1] = desc.boundary[2] = DEM_BOUNDARY_PERIODIC;
        desc.domain = dem_box_make(0, 0, 0, L, L, L);
    }
    for (c = 0; c < 3 && o->open; c++) desc.boundary[c] = DEM_BOUNDARY_OPEN;
    world = dem_world_create(&desc);
    if (!world) { study_fail("%s: %s", s->name, dem_world_create_error_get(&desc)); return 0; }

    m.density = (dem_real)BENCH_DENSITY;
    m.restitution = (dem_real)(gas ? BENCH_GAS_RESTITUTION : BENCH_RESTITUTION);
    m.young = (dem_real)BENCH_YOUNG;
    m.poisson = (dem_real)BENCH_POISSON;
    if (!gas && !o->smooth) m.friction = (dem_real)BENCH_FRICTION;
    if (o->adhesion) m.restitution = 1;
    if (o->adhesion == 2) m.stiffness_adhesion = 100;               /* N/m */
    if (gas) m.stiffness = (dem_real)(2*BENCH_GAS_STIFFNESS);
    m.rolling_friction = (dem_real)o->rolling_friction;
    material = dem_material_add(world, &m);
    if (gas && material.id) {           /* the stiffness of a pair as it is, not two in series      */
        ok = dem_pair_get(world, material, material, &pair) == DEM_OK;
        pair.stiffness = (dem_real)BENCH_GAS_STIFFNESS;
        ok = ok && dem_pair_set(world, material, material, &pair) == DEM_OK;
    }
    ok = ok && material.id;
    if (bed) ok = ok && dem_wall_plane_add(world, material, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1)).id;
    if (drum) ok = ok && bench_drum_walls(world, material, degrees, o->cuts) && bench_drum_flow(world, material, o);
    ok = ok && bench_field(world, s, o);
    if (o->ledger > 1) ok = ok && dem_events_record(world, &DEM_EVENTS_DESC) == DEM_OK;

    x = (dem_real *)study_alloc((size_t)count*3, sizeof *x);
    v = (dem_real *)study_alloc((size_t)count*3, sizeof *v);
    r = (dem_real *)study_alloc((size_t)count, sizeof *r);
    for (i = 0; i < count; i++) {
        r[i] = (dem_real)(s->radius*(1 - bench_smaller(o->mixed, i)));
        for (c = 0; c < 3; c++) {
            x[3*i + c] = (dem_real)s->x[3*i*every + c];
            v[3*i + c] = (dem_real)s->v[3*i*every + c];
        }
    }
    if (o->shaped) shape = bench_shape(world, o->shaped, (dem_real)s->radius);
    balls = o->shaped == 4 ? count - 1 : o->shaped ? 0 : count;
    result = ok ? DEM_OK : DEM_ERROR_ARGUMENT;
    if (result == DEM_OK && balls) result = dem_spheres_add(world, material, balls, x, v, r, 0);
    if (result == DEM_OK && balls < count)
        result = dem_bodies_add(world, material, shape, count - balls, x + 3*balls, 0, v + 3*balls, 0, 0);
    for (i = 0; i < count && result == DEM_OK; i++) {
        const double *spin = s->spin + 3*i*every;
        dem_body_state state;
        dem_body body;
        if (!(fabs(spin[0]) + fabs(spin[1]) + fabs(spin[2]) > 0)) continue;
        body = dem_body_id_get(world, i);
        result = dem_body_get(world, body, &state);
        state.spin = dem_vec3_make((dem_real)spin[0], (dem_real)spin[1], (dem_real)spin[2]);
        if (result == DEM_OK) result = dem_body_set(world, body, &state);
    }
    free(x); free(v); free(r);
    if (!ok || result != DEM_OK) {
        study_fail("%s: %s", s->name, dem_world_error_get(world));
        dem_world_destroy(world);
        return 0;
    }
    return world;
}
/* Lowers a plane on BED as a servo wall until it presses with about its target, 500 Pa. */
STUDY_FN int bench_lid(dem_world *world, const bench_scene *s, int lid) {
    dem_motion motion = DEM_MOTION;
    dem_body_state first;
    dem_wall wall;
    double top = 0;
    int i;
    if (dem_body_get(world, dem_body_id_get(world, 0), &first) != DEM_OK) return 0;
    for (i = 0; i < s->count; i++) top = fmax(top, s->x[3*i + 2] + s->radius);
    wall = dem_wall_plane_add(world, first.material, dem_vec3_make(0, 0, (dem_real)top), dem_vec3_make(0, 0, -1));
    motion.kind = DEM_MOTION_SERVO;
    motion.velocity.z = DEM_R(-0.2);
    motion.load = 500;
    motion.area = (dem_real)(s->side[0]*s->side[1]);
    if (dem_wall_motion_set(world, wall, &motion) != DEM_OK || dem_world_step(world, BENCH_LID_STEPS) != DEM_OK) return 0;
    return lid == 2 || dem_wall_motion_set(world, wall, &DEM_MOTION) == DEM_OK;
}
STUDY_FN dem_world *bench_world(const bench_scene *s, const bench_choice *choice) {
    dem_world *world = bench_world_at(s, choice, BENCH_DRUM_ANGLE);
    if (!world || !choice->lid || bench_lid(world, s, choice->lid)) return world;
    study_fail("%s: %s", s->name, dem_world_error_get(world));
    dem_world_destroy(world);
    return 0;
}

#endif /* BENCH_SCENES_H */
