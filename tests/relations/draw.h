/* draw.h - draws scenes. A row of rel_features is one feature of dem.h: how it is added with random but valid values,
   and how it shows that it acted. Rows of one group exclude each other; a group with `must` gets exactly one row.
   A feature that does not suit the scene so far returns 0 and is left out; a scene that dem.h refuses counts as
   refused, with the message. */
#ifndef REL_DRAW_H
#define REL_DRAW_H
#include "run.h"

typedef struct rel_draw {
    rel_scene *s;
    rel_rng *r;
    int feature;                               /* the row being added */
    double R, a, h;                            /* m: radius; half width and height of the container */
    int planar, impulses, periodic, round, bumps, moved, scaled;
    int attempt;                               /* how often nothing happened in this scene */
    double top;                                /* m: no body is above it at first */
    int material[3], materials;
    int shape[12]; double reach[12]; int shapes;             /* op, -1: sphere; bounding radius, m */
    int wall[16], walls, container;            /* ops; how many of them belong to the container */
    int body[64], bodies;
} rel_draw;
static rel_op *rel_add(rel_draw *d, int call, int step) {
    rel_op *op;
    if (d->s->count >= REL_OPS) exit(3);
    op = &d->s->op[d->s->count++];
    memset(op, 0, sizeof *op);
    op->call = call;
    op->step = step;
    op->feature = d->feature;
    return op;
}
static int rel_index(const rel_draw *d, const rel_op *op) { return (int)(op - d->s->op); }
/* Sets a field by name to one, three, four or six numbers. */
static rel_set *rel_slot(rel_op *op, const char *name) {
    const int f = rel_field_of(op->call, name);
    int i;
    for (i = 0; i < op->count && op->set[i].field != f; i++) continue;
    if (i == op->count) op->count++;
    if (i >= REL_SETS) exit(3);
    memset(&op->set[i], 0, sizeof op->set[i]);
    op->set[i].field = f;
    return &op->set[i];
}
static void rel_put(rel_op *op, const char *name, double x) { rel_slot(op, name)->v[0] = x; }
static void rel_put3(rel_op *op, const char *name, double x, double y, double z) {
    rel_set *v = rel_slot(op, name);
    v->v[0] = x; v->v[1] = y; v->v[2] = z;
}
static void rel_put_box(rel_op *op, const char *name, double x, double y, double z, double x1, double y1, double z1) {
    rel_set *v = rel_slot(op, name);
    v->v[0] = x; v->v[1] = y; v->v[2] = z; v->v[3] = x1; v->v[4] = y1; v->v[5] = z1;
}
static void rel_list(rel_draw *d, rel_op *op, const char *name, const double *x, int count) {
    rel_set *v = rel_slot(op, name);
    if (d->s->pool_count + count > REL_POOL) exit(3);
    v->count = count;
    v->at = d->s->pool_count;
    memcpy(d->s->pool + v->at, x, (size_t)count*sizeof *x);
    d->s->pool_count += count;
}
static rel_op *rel_the_world(rel_draw *d) { return &d->s->op[0]; }
static double rel_vary(rel_draw *d, double a, double b) { return rel_between(d->r, a, b); }
static int rel_any(rel_draw *d, int n) { return rel_below(d->r, n); }
static int rel_stuff(rel_draw *d) { return d->material[rel_any(d, d->materials)]; }

/* ---- the world: each sets a field ---- */
static int rel_springs(rel_draw *d) { (void)d; return 1; }
static int rel_impulses(rel_draw *d) {
    d->impulses = 1;
    rel_put(rel_the_world(d), "response", DEM_RESPONSE_IMPULSES);
    rel_put(rel_the_world(d), "dt", rel_vary(d, 1e-4, 5e-4));
    rel_put(rel_the_world(d), "tolerance", sizeof(dem_real) == sizeof(double) ? 1e-9 : 1e-5);
    rel_put(rel_the_world(d), "sweeps", 2000);
    d->s->steps = 30 + rel_any(d, 60);
    return 1;
}
#define REL_OPTION(function, field, value, condition) \
    static int function(rel_draw *d) { if (!(condition)) return 0; rel_put(rel_the_world(d), field, value); return 1; }
REL_OPTION(rel_linear, "normal_law", DEM_NORMAL_LINEAR, !d->impulses)
REL_OPTION(rel_hysteretic, "normal_law", DEM_NORMAL_HYSTERETIC, !d->impulses)
REL_OPTION(rel_viscous, "tangent_law", DEM_TANGENT_VISCOUS, !d->impulses)
REL_OPTION(rel_step_law, "tangent_law", DEM_TANGENT_STEP, !d->impulses)
REL_OPTION(rel_mindlin, "tangent_law", DEM_TANGENT_MINDLIN, !d->impulses)
REL_OPTION(rel_rescaled, "tangent_law", DEM_TANGENT_MINDLIN_RESCALED, !d->impulses)
REL_OPTION(rel_no_tangent, "tangent_law", DEM_TANGENT_NONE, !d->impulses)
REL_OPTION(rel_roll_constant, "rolling_law", DEM_ROLLING_CONSTANT, !d->impulses)
REL_OPTION(rel_roll_epsd, "rolling_law", DEM_ROLLING_EPSD, !d->impulses)
REL_OPTION(rel_clipped, "tension", DEM_TENSION_CLIPPED, !d->impulses)
REL_OPTION(rel_compensated, "tension", DEM_TENSION_COMPENSATED, !d->impulses)
REL_OPTION(rel_load_elastic, "friction_load", DEM_LOAD_ELASTIC, !d->impulses)
REL_OPTION(rel_load_magnitude, "friction_load", DEM_LOAD_MAGNITUDE, !d->impulses)
REL_OPTION(rel_slider_spring, "slider", DEM_SLIDER_SPRING, !d->impulses)
REL_OPTION(rel_slider_remainder, "slider", DEM_SLIDER_REMAINDER, !d->impulses)
REL_OPTION(rel_forward_euler, "integrator", DEM_INTEGRATOR_FORWARD_EULER, !d->impulses)
REL_OPTION(rel_symplectic_euler, "integrator", DEM_INTEGRATOR_SYMPLECTIC_EULER, !d->impulses)
REL_OPTION(rel_position_verlet, "integrator", DEM_INTEGRATOR_POSITION_VERLET, !d->impulses)
REL_OPTION(rel_leapfrog, "integrator", DEM_INTEGRATOR_LEAPFROG, !d->impulses)
REL_OPTION(rel_jacobi, "solver", DEM_SOLVER_JACOBI, d->impulses)
REL_OPTION(rel_apgd, "solver", DEM_SOLVER_APGD, d->impulses)
REL_OPTION(rel_spectral, "solver", DEM_SOLVER_SPECTRAL, d->impulses)
REL_OPTION(rel_convex, "cone", DEM_CONE_CONVEX, d->impulses)
REL_OPTION(rel_cold, "cold_start", 1, d->impulses)
REL_OPTION(rel_fincham, "rotation", DEM_ROTATION_FINCHAM, 1)
REL_OPTION(rel_no_squish, "rotation", DEM_ROTATION_NO_SQUISH, 1)
REL_OPTION(rel_chord, "ellipsoid_overlap", DEM_OVERLAP_CHORD, !d->impulses)
REL_OPTION(rel_normal_overlap, "ellipsoid_overlap", DEM_OVERLAP_NORMAL, !d->impulses)
REL_OPTION(rel_separate, "cluster_contacts", DEM_CLUSTER_CONTACTS_SEPARATE, !d->impulses)
REL_OPTION(rel_followed, "orientations", 1, 1)
REL_OPTION(rel_ledger_on, "ledger", 1, 1)
REL_OPTION(rel_search_pairs, "search", DEM_SEARCH_ALL_PAIRS, 1)
REL_OPTION(rel_search_list, "search", DEM_SEARCH_LINKED_LIST, 1)
REL_OPTION(rel_search_levels, "search", DEM_SEARCH_HIERARCHICAL, 1)
REL_OPTION(rel_search_bins, "search", DEM_SEARCH_BINS, 1)
REL_OPTION(rel_skin_none, "skin", -1, 1)
REL_OPTION(rel_skin_narrow, "skin", 0.02*d->R, 1)
REL_OPTION(rel_skin_wide, "skin", 0.8*d->R, 1)
REL_OPTION(rel_drag, "force", rel_code_of("drag"), 1)
REL_OPTION(rel_swirl, "body_force", rel_code_of("swirl"), 1)
REL_OPTION(rel_growth, "growth", rel_code_of("grow"), 1)
static int rel_planar(rel_draw *d) {
    rel_put(rel_the_world(d), "planar", 1);
    rel_put(rel_the_world(d), "thickness", 2*d->R);
    return d->planar = 1;
}
static int rel_numbers(rel_draw *d) {
    rel_put(rel_the_world(d), "body_reals", 0);
    if (rel_chance(d->r, 0.5)) rel_put(rel_the_world(d), "body_reals_fn", rel_code_of("numbers"));
    return 1;
}
static int rel_law(rel_draw *d) {
    const int plain = rel_chance(d->r, 0.5);
    if (d->impulses) return 0;
    rel_put(rel_the_world(d), "law", rel_code_of(plain ? "law_plain" : "law_spring"));
    if (plain) rel_put(rel_the_world(d), "normal_law", DEM_NORMAL_LINEAR);     /* its stiffness is the law's */
    rel_put(rel_the_world(d), "law_memory", 3);
    rel_put(rel_the_world(d), "law_vectors", 1);
    return 1;
}
static int rel_gravity(rel_draw *d) {
    rel_put3(rel_the_world(d), "gravity", 0, d->planar ? -9.81 : 0, d->planar ? 0 : -9.81);
    return 1;
}
static int rel_gravity_tilted(rel_draw *d) {
    rel_put3(rel_the_world(d), "gravity", rel_vary(d, -5, 5), rel_vary(d, -5, 5), d->planar ? 0 : rel_vary(d, -9, 0));
    return 1;
}
/* ---- materials ---- */
static int rel_material(rel_draw *d) {
    rel_op *m = rel_add(d, REL_MATERIAL, 0);
    rel_put(m, "density", rel_vary(d, 1000, 3000));
    rel_put(m, "young", rel_vary(d, 2e6, 1e7));
    rel_put(m, "poisson", rel_vary(d, 0, 0.4));
    rel_put(m, "restitution", rel_vary(d, 0.3, 0.95));
    rel_put(m, "friction", rel_chance(d->r, 0.2) ? 0 : rel_vary(d, 0.1, 0.8));
    d->material[d->materials++] = rel_index(d, m);
    return 1;
}
static int rel_two_materials(rel_draw *d) { return rel_material(d); }
static int rel_stiffness(rel_draw *d) {
    int i;
    for (i = 0; i < d->materials; i++) rel_put(&d->s->op[d->material[i]], "stiffness", rel_vary(d, 500, 3000));
    return !d->impulses;
}
static int rel_rolling(rel_draw *d) {
    rel_put(&d->s->op[rel_stuff(d)], "rolling_friction", rel_vary(d, 0.01, 0.3));
    return 1;
}
static int rel_static(rel_draw *d) {
    rel_op *m = &d->s->op[rel_stuff(d)];
    rel_put(m, "friction", 0.3);
    rel_put(m, "friction_static", 0.5);
    return 1;
}
static rel_op *rel_pair_of(rel_draw *d) {
    rel_op *p = rel_add(d, REL_PAIR, 0);
    rel_put(p, "a", d->material[0]);
    rel_put(p, "b", d->material[d->materials - 1]);
    return p;
}
static int rel_ignored(rel_draw *d) { if (d->materials < 2) return 0; rel_put(rel_pair_of(d), "ignored", 1); return 1; }
static int rel_cohesion(rel_draw *d) {
    if (d->impulses) rel_put(rel_pair_of(d), "cohesion", rel_vary(d, 1e-5, 1e-4));
    return d->impulses;
}
static int rel_compliance(rel_draw *d) {
    if (d->impulses) rel_put(rel_pair_of(d), "compliance", rel_vary(d, 1e-4, 1e-3));
    return d->impulses;
}
static int rel_spinning(rel_draw *d) { rel_put(rel_pair_of(d), "spinning_friction", rel_vary(d, 0.01, 0.2)); return 1; }

/* ---- shapes ---- */
static int rel_shape(rel_draw *d, int op, double reach) {
    d->shape[d->shapes] = op;
    d->reach[d->shapes++] = reach;
    return 1;
}
static int rel_spheres(rel_draw *d) { return rel_shape(d, -1, d->R); }
static int rel_spheres_small(rel_draw *d) { return rel_shape(d, -1, d->R/2); }
static int rel_ellipsoid(rel_draw *d) {
    rel_op *s;
    if (d->planar) return 0;
    s = rel_add(d, REL_ELLIPSOID, 0);
    rel_put3(s, "axes", d->R, rel_vary(d, 0.5, 1)*d->R, rel_vary(d, 0.4, 0.9)*d->R);
    return rel_shape(d, rel_index(d, s), d->R);
}
static int rel_cluster(rel_draw *d, int n) {
    double x[12] = {0}, r[4];
    rel_op *s;
    int i, k;
    if (d->planar) return 0;
    s = rel_add(d, REL_CLUSTER, 0);
    for (i = 0; i < n; i++) {
        r[i] = rel_vary(d, 0.45, 0.6)*d->R;
        for (k = 0; k < 3 && n > 1; k++) x[3*i + k] = rel_vary(d, -0.3, 0.3)*d->R;
    }
    rel_list(d, s, "positions", x, 3*n);
    rel_list(d, s, "radii", r, n);
    return rel_shape(d, rel_index(d, s), 1.1*d->R);
}
static int rel_cluster_one(rel_draw *d) { return rel_cluster(d, 1); }
static int rel_cluster_many(rel_draw *d) { return rel_cluster(d, 2 + rel_any(d, 3)); }
static int rel_cube(rel_draw *d) {
    double x[24];
    rel_op *s;
    int i, k;
    if (d->planar) return 0;
    s = rel_add(d, REL_POLYHEDRON, 0);
    for (i = 0; i < 8; i++) for (k = 0; k < 3; k++) x[3*i + k] = (i >> k & 1 ? 0.5 : -0.5)*d->R;
    rel_list(d, s, "points", x, 24);
    return rel_shape(d, rel_index(d, s), d->R);
}
static int rel_rock(rel_draw *d) {
    static const double base[30] = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0.6, 0.6, 0.5, -0.6,
        0.5, -0.5,
                                    0.5, -0.6, 0.5, -0.5, -0.5, -0.6};
    double x[30];
    rel_op *s;
    int i;
    if (d->planar) return 0;
    s = rel_add(d, REL_POLYHEDRON, 0);
    for (i = 0; i < 30; i++) x[i] = base[i]*rel_vary(d, 0.8, 1)*d->R;
    rel_list(d, s, "points", x, 30);
    return rel_shape(d, rel_index(d, s), 1.1*d->R);
}
static int rel_polygon(rel_draw *d) {
    const int n = 3 + rel_any(d, 4);
    double x[12];
    rel_op *s;
    int i;
    if (!d->planar) return 0;
    s = rel_add(d, REL_POLYGON, 0);
    for (i = 0; i < n; i++) {
        x[2*i] = d->R*cos(6.283185307179586*i/n)*rel_vary(d, 0.9, 1);
        x[2*i + 1] = d->R*sin(6.283185307179586*i/n)*rel_vary(d, 0.9, 1);
    }
    rel_list(d, s, "corners", x, 2*n);
    return rel_shape(d, rel_index(d, s), 1.05*d->R);
}
static int rel_union(rel_draw *d) {
    double of[2], at[6] = {0};
    rel_op *s;
    int i;
    for (i = 0; i < d->shapes && (d->shape[i] < 0 || d->s->op[d->shape[i]].call == REL_CLUSTER); i++) continue;
    if (i == d->shapes || d->planar || d->shapes > 10) return 0;
    of[0] = of[1] = d->shape[i];
    s = rel_add(d, REL_UNION, 0);
    at[0] = 0.4*d->R;
    at[3] = -0.4*d->R;
    rel_list(d, s, "shapes", of, 2);
    rel_list(d, s, "positions", at, 6);
    return rel_shape(d, rel_index(d, s), 1.6*d->R);
}
/* ---- containers: walls around |x|, |y| < a and 0 < z < h; planar: |x| < a, 0 < y < h ---- */
static int rel_wall(rel_draw *d, rel_op *op) { return d->wall[d->walls++] = rel_index(d, op); }
static rel_op *rel_plane_at(rel_draw *d, double x, double y, double z, double nx, double ny, double nz) {
    rel_op *p = rel_add(d, REL_PLANE, 0);
    rel_put(p, "material", rel_stuff(d));
    rel_put3(p, "point", x, y, z);
    rel_put3(p, "normal", nx, ny, nz);
    rel_wall(d, p);
    return p;
}
static void rel_sides(rel_draw *d) {
    rel_plane_at(d, -d->a, 0, 0, 1, 0, 0);
    rel_plane_at(d, d->a, 0, 0, -1, 0, 0);
    if (d->planar) return;
    rel_plane_at(d, 0, -d->a, 0, 0, 1, 0);
    rel_plane_at(d, 0, d->a, 0, 0, -1, 0);
}
static int rel_planes(rel_draw *d) {
    if (d->planar) rel_plane_at(d, 0, 0, 0, 0, 1, 0);
    else rel_plane_at(d, 0, 0, 0, 0, 0, 1);
    if (!d->periodic) rel_sides(d);
    return 1;
}
/* A floor of n x n squares, each two triangles, with half width `a`; `bump`: of inner corners. */
static rel_op *rel_floor_mesh(rel_draw *d, double a, int n, double bump) {
    rel_op *m = rel_add(d, REL_MESH, 0);
    double x[3*36], t[6*25];
    int i, j, k = 0;
    for (j = 0; j <= n; j++)
        for (i = 0; i <= n; i++) {
            double *p = x + 3*(i + (n + 1)*j);
            p[0] = a*(2.0*i/n - 1);
            p[1] = a*(2.0*j/n - 1);
            p[2] = i > 0 && i < n && j > 0 && j < n ? rel_vary(d, -bump, bump) : 0;
        }
    for (j = 0; j < n; j++)
        for (i = 0; i < n; i++) {
            const int p = i + (n + 1)*j, q = p + n + 1;
            const int c[6] = {p, p + 1, q + 1, p, q + 1, q};
            int e;
            for (e = 0; e < 6; e++) t[k++] = c[e];
        }
    rel_put(m, "material", rel_stuff(d));
    rel_list(d, m, "vertices", x, 3*(n + 1)*(n + 1));
    rel_list(d, m, "triangles", t, k);
    rel_wall(d, m);
    return m;
}
static int rel_mesh_flat(rel_draw *d) {
    if (d->planar || d->periodic) return 0;
    rel_floor_mesh(d, 1.5*d->a, 1 + rel_any(d, 4), 0);
    rel_sides(d);
    return 1;
}
static int rel_mesh_bumpy(rel_draw *d) {
    if (d->planar || d->periodic) return 0;
    rel_floor_mesh(d, 1.5*d->a, 2 + rel_any(d, 3), 0.3*d->R);
    rel_sides(d);
    return d->bumps = 1;
}
static int rel_profile(rel_draw *d) {
    double x[12], s[10];
    const int n = 2 + rel_any(d, 3);
    rel_op *p;
    int i;
    if (d->periodic) return 0;
    p = rel_add(d, REL_PROFILE, 0);
    for (i = 0; i <= n; i++) {
        x[2*i] = 1.5*d->a*(2.0*i/n - 1);
        x[2*i + 1] = d->planar ? (i > 0 && i < n ? rel_vary(d, -0.3, 0.3)*d->R : 0) : -d->a;
        if (i < n) { s[2*i] = i; s[2*i + 1] = i + 1; }
    }
    rel_put(p, "material", rel_stuff(d));
    rel_list(d, p, "vertices", x, 2*(n + 1));
    rel_list(d, p, "triangles", s, 2*n);
    rel_wall(d, p);
    if (!d->planar) rel_plane_at(d, 0, 0, 0, 0, 0, 1);
    rel_sides(d);
    return d->bumps = 1;
}
static int rel_cylinder(rel_draw *d) {
    rel_op *c;
    if (d->periodic) return 0;
    c = rel_add(d, REL_CYLINDER, 0);
    rel_put(c, "material", rel_stuff(d));
    rel_put3(c, "point", 0, d->planar ? d->h/2 : 0, 0);
    rel_put3(c, "axis", 0, 0, 1);
    rel_put(c, "radius", d->planar ? d->h/2 : d->a);
    rel_wall(d, c);
    d->round = 1;
    if (!d->planar) rel_plane_at(d, 0, 0, 0, 0, 0, 1);
    return 1;
}
static int rel_revolved(rel_draw *d) {
    const double r[4] = {0, d->a, d->a, 1.2*d->a}, z[4] = {0, 0, d->h, 1.2*d->h};
    rel_op *c;
    if (d->planar || d->periodic) return 0;
    c = rel_add(d, REL_REVOLVED, 0);
    rel_put(c, "material", rel_stuff(d));
    rel_put3(c, "axis", 0, 0, 1);
    if (rel_chance(d->r, 0.3)) rel_put3(c, "point", 0.05*d->R, 0, -0.1*d->R);
    rel_list(d, c, "radii", r, 4);
    rel_list(d, c, "heights", z, 4);
    rel_wall(d, c);
    return d->round = 1;
}
static int rel_cone(rel_draw *d) {
    rel_op *c;
    if (d->planar || d->periodic) return 0;
    c = rel_add(d, REL_CONE, 0);
    rel_put(c, "material", rel_stuff(d));
    rel_put3(c, "point", 0, 0, 0);
    rel_put3(c, "to", 0, 0, d->h);
    rel_put(c, "radius", d->a);
    rel_put(c, "radius_to", 1.3*d->a);
    rel_wall(d, c);
    rel_plane_at(d, 0, 0, 0, 0, 0, 1);
    return d->round = 1;
}
static int rel_grains(rel_draw *d) {
    double x[3*64];
    const double step = 1.5*d->R;
    const int n = (int)(2*d->a/step) > 7 ? 7 : (int)(2*d->a/step);
    rel_op *g;
    int i, j, k = 0;
    if (d->planar || d->periodic) return 0;
    g = rel_add(d, REL_GRAINS, 0);
    for (i = 0; i <= n; i++)
        for (j = 0; j <= n; j++) { x[k++] = step*(i - n/2.0); x[k++] = step*(j - n/2.0); x[k++] = -0.9*d->R; }
    rel_put(g, "material", rel_stuff(d));
    rel_list(d, g, "vertices", x, k);
    rel_put(g, "radius", 0.9*d->R);
    if (rel_chance(d->r, 0.3)) rel_put(g, "share", 0.5);
    rel_wall(d, g);
    rel_plane_at(d, 0, 0, -d->R, 0, 0, 1);
    rel_sides(d);
    return 1;
}
static int rel_sieve(rel_draw *d) {
    rel_op *g;
    if (d->planar || d->periodic) return 0;
    g = rel_add(d, REL_SIEVE, 0);
    rel_put(g, "material", rel_stuff(d));
    rel_put(g, "kind", DEM_SIEVE_WIRES);       /* or as a later row says */
    if (rel_chance(d->r, 0.3)) rel_put3(g, "d.point", 0.3*d->R, 0.2*d->R, 0);
    rel_put3(g, "normal", 0, 0, 1);
    rel_put3(g, "along", 1, 0, 0);
    rel_put(g, "aperture", rel_vary(d, 1, 1.8)*d->R);
    rel_put(g, "bar", rel_vary(d, 0.4, 0.8)*d->R);
    rel_wall(d, g);
    rel_plane_at(d, 0, 0, -4*d->R, 0, 0, 1);
    rel_sides(d);
    return 1;
}
static void rel_period(rel_draw *d, int axes, double h) {
    rel_put_box(rel_the_world(d), "domain", -d->a, d->planar ? 0 : -d->a, d->planar ? -d->R : 0, d->a,
                d->planar ? h : d->a, d->planar ? d->R : h);
    rel_put3(rel_the_world(d), "boundary", axes & 1 ? DEM_BOUNDARY_PERIODIC : 0, axes & 2 ? DEM_BOUNDARY_PERIODIC : 0,
             axes & 4 ? DEM_BOUNDARY_PERIODIC : 0);
    d->periodic = axes;
}
static int rel_periodic_floor(rel_draw *d) { rel_period(d, d->planar ? 1 : 3, d->h); return rel_planes(d); }
static int rel_periodic_all(rel_draw *d) { rel_period(d, d->planar ? 3 : 7, d->h); return 1; }
static int rel_open(rel_draw *d) { (void)d; return 1; }
/* ---- bodies: on a lattice just wider than they are, in random orientations ---- */
static void rel_one_body(rel_draw *d, double x, double y, double z, double speed) {
    const int k = rel_any(d, d->shapes), shape = d->shape[k];
    rel_op *b = rel_add(d, REL_A_BODY, 0);
    rel_put(b, "material", rel_stuff(d));
    if (shape >= 0) {
        rel_set *q;
        rel_put(b, "shape", shape);
        if (d->scaled) rel_put(b, "scale", rel_vary(d, 0.6, 1));
        q = rel_slot(b, "orientation");
        q->v[0] = rel_vary(d, 0.2, 1);
        q->v[1] = d->planar ? 0 : rel_vary(d, -1, 1);
        q->v[2] = d->planar ? 0 : rel_vary(d, -1, 1);
        q->v[3] = rel_vary(d, -1, 1);
    } else rel_put(b, "radius", rel_chance(d->r, 0.3) ? 0.8*d->reach[k] : d->reach[k]);
    rel_put3(b, "position", x, y, z);
    rel_put3(b, "velocity", rel_vary(d, -speed, speed), rel_vary(d, -speed, speed),
        d->planar ? 0 : rel_vary(d, -speed, speed));
    if (rel_chance(d->r, 0.5))
        rel_put3(b, "spin", d->planar ? 0 : rel_vary(d, -50, 50), d->planar ? 0 : rel_vary(d, -50, 50),
            rel_vary(d, -50, 50));
    d->body[d->bodies++] = rel_index(d, b);
}
static int rel_fill(rel_draw *d) {
    const int most = 2 + rel_any(d, rel_chance(d->r, 0.3) ? 40 : 12);
    const double speed = rel_vary(d, 0.1, 0.8)*(1 + 2*d->attempt);
    double reach = 0, step, low, x, y, z;
    int i;
    for (i = 0; i < d->shapes; i++) reach = d->reach[i] > reach ? d->reach[i] : reach;
    step = 2.02*reach;
    low = reach*1.02 + (d->bumps ? 0.31*d->R : 0);
    for (z = low; z < (d->planar ? low*1.01 : d->h - reach) && d->bodies < most; z += step)
        for (y = d->planar ? low : -d->a + 1.02*reach; y < (d->planar ? d->h - reach : d->a - reach) &&
            d->bodies < most; y += step)
            for (x = -d->a + 1.02*reach; x <= d->a - 1.02*reach && d->bodies < most; x += step) {
                const double v = d->planar ? y - d->h/2 : y, room = (d->planar && d->round ? d->h/2 : d->a) - 1.1*reach;
                if (d->round && x*x + v*v > room*room) continue;
                rel_one_body(d, x, y, d->planar ? 0 : z, speed);
                d->top = z + reach;
            }
    return d->bodies > 0;
}
/* ---- what happens later, or beside ---- */
static int rel_when(rel_draw *d) { return 1 + rel_any(d, d->s->steps - 1); }
static rel_op *rel_move(rel_draw *d, int kind) {
    rel_op *m;
    if (!d->walls || d->moved) return 0;
    d->moved = 1;
    m = rel_add(d, REL_MOTION, rel_chance(d->r, 0.3) ? rel_when(d) : 0);
    rel_put(m, "wall", d->wall[0]);
    rel_put(m, "kind", kind);
    if (rel_chance(d->r, 0.3)) rel_put(m, "ramp", rel_vary(d, 1e-4, 1e-2));
    if (rel_chance(d->r, 0.3)) rel_put(m, "start", rel_vary(d, 0, 2e-3));
    return m;
}
static int rel_translating(rel_draw *d) {
    rel_op *m = rel_move(d, DEM_MOTION_TRANSLATING);
    if (m) rel_put3(m, "velocity", rel_vary(d, -0.05, 0.05), rel_vary(d, -0.05, 0.05),
        d->planar ? 0 : rel_vary(d, -0.05, 0.05));
    return m != 0;
}
static int rel_rotating(rel_draw *d) {
    rel_op *m = rel_move(d, DEM_MOTION_ROTATING);
    if (!m) return 0;
    rel_put3(m, "axis", 0, 0, 1);
    rel_put(m, "speed", rel_vary(d, -20, 20));
    if (rel_chance(d->r, 0.3)) rel_put3(m, "point", 0.2*d->R, 0.1*d->R, 0);
    return 1;
}
static int rel_oscillating(rel_draw *d) {
    rel_op *m = rel_move(d, DEM_MOTION_OSCILLATING);
    if (!m) return 0;
    rel_put3(m, "velocity", d->planar ? 0 : rel_vary(d, -1, 1), d->planar ? 1 : 0, d->planar ? 0 : 1);
    rel_put(m, "amplitude", 0.2*d->R);
    rel_put(m, "frequency", rel_vary(d, 20, 100));
    return 1;
}
static int rel_nodding(rel_draw *d) {
    rel_op *m = d->planar || d->periodic ? 0 : rel_move(d, DEM_MOTION_USER);
    if (!m) return 0;
    m->count = 0;
    m->step = 0;
    rel_put(m, "wall", d->wall[0]);
    rel_put(m, "kind", DEM_MOTION_USER);
    rel_put(m, "function", rel_code_of("nod"));
    return 1;
}
static int rel_servo(rel_draw *d) {
    rel_op *p, *m;
    if (d->impulses || d->planar || d->periodic == 7) return 0;
    p = rel_plane_at(d, 0, 0, d->h, 0, 0, -1);
    m = rel_add(d, REL_MOTION, 0);
    rel_put(m, "wall", rel_index(d, p));
    rel_put(m, "kind", DEM_MOTION_SERVO);
    rel_put3(m, "velocity", 0, 0, -0.5);
    rel_put(m, "load", rel_vary(d, 1e-4, 1e-2));
    return 1;
}
static int rel_belt(rel_draw *d) {
    rel_op *b;
    if (!d->walls) return 0;
    b = rel_add(d, REL_BELT, rel_chance(d->r, 0.3) ? rel_when(d) : 0);
    rel_put(b, "wall", d->wall[0]);
    rel_put3(b, "velocity", rel_vary(d, -0.3, 0.3), d->planar ? 0 : rel_vary(d, -0.3, 0.3), 0);
    return 1;
}
static int rel_wall_gone(rel_draw *d) {
    if (d->walls < 2) return 0;
    rel_put(rel_add(d, REL_WALL_REMOVE, rel_when(d)), "wall", d->wall[d->walls - 1]);
    d->walls--;
    return 1;
}
static int rel_some_body(rel_draw *d) { return d->body[rel_any(d, d->bodies)]; }
static int rel_fixed(rel_draw *d) {
    rel_op *f = rel_add(d, REL_FIX, rel_chance(d->r, 0.3) ? rel_when(d) : 0);
    rel_put(f, "body", rel_some_body(d));
    rel_put(f, "fixed", 1);
    return 1;
}
static int rel_kicked(rel_draw *d) {
    rel_op *k = rel_add(d, REL_KICK, rel_when(d));
    rel_put(k, "body", rel_some_body(d));
    rel_put3(k, "velocity", rel_vary(d, -0.3, 0.3), rel_vary(d, -0.3, 0.3), d->planar ? 0 : rel_vary(d, -0.3, 0.3));
    rel_put3(k, "spin", 0, 0, rel_vary(d, -30, 30));
    return 1;
}
static int rel_removed(rel_draw *d) {
    if (d->bodies < 2) return 0;
    rel_put(rel_add(d, REL_REMOVE, rel_when(d)), "body", d->body[--d->bodies]);
    return 1;
}
static int rel_resized(rel_draw *d) {
    const int b = rel_some_body(d);
    const rel_op *body = &d->s->op[b];
    rel_op *k;
    int i;
    for (i = 0; i < body->count && body->set[i].field != rel_field_of(REL_A_BODY, "radius"); i++) continue;
    if (i == body->count) return 0;
    k = rel_add(d, REL_RESIZE, rel_when(d));
    rel_put(k, "body", b);
    rel_put(k, "radius", body->set[i].v[0]*0.97);
    return 1;
}
static int rel_gravity_later(rel_draw *d) {
    rel_put3(rel_add(d, REL_GRAVITY, rel_when(d)), "gravity", rel_vary(d, -9, 9), rel_vary(d, -9, 9),
        d->planar ? 0 : rel_vary(d, -9, 9));
    return 1;
}
static int rel_join(rel_draw *d, int kind, int motor) {
    const int a = rel_some_body(d), b = rel_chance(d->r, 0.6) ? rel_some_body(d) : -1;
    const rel_set *x = &d->s->op[a].set[0];
    rel_op *j;
    int i;
    if (!d->impulses || a == b) return 0;
    rel_put(rel_the_world(d), "orientations", 1);
    for (i = 0; i < d->s->op[a].count; i++)
        if (d->s->op[a].set[i].field == rel_field_of(REL_A_BODY, "position")) x = &d->s->op[a].set[i];
    j = rel_add(d, REL_JOINT, 0);
    rel_put(j, "kind", kind);
    rel_put(j, "a", a);
    rel_put(j, "b", b);
    rel_put3(j, "point", x->v[0] + 0.5*d->R, x->v[1], x->v[2]);
    if (kind == DEM_JOINT_REVOLUTE) rel_put3(j, "axis", 0, 0, 1);
    if (motor) { rel_put(j, "motor", motor); rel_put(j, "speed", rel_vary(d, -10, 10)); rel_put(j, "torque", 1e-6); }
    return 1;
}
static int rel_joint_point(rel_draw *d) { return rel_join(d, DEM_JOINT_POINT, 0); }
static int rel_joint_hinge(rel_draw *d) { return rel_join(d, DEM_JOINT_REVOLUTE, 0); }
static int rel_motor(rel_draw *d) { return rel_join(d, DEM_JOINT_REVOLUTE, DEM_MOTOR_SPEED); }
static int rel_rail(rel_draw *d) {
    rel_op *r = rel_add(d, REL_RAIL, rel_chance(d->r, 0.3) ? rel_when(d) : 0);
    rel_put(r, "body", rel_some_body(d));
    rel_put(r, "d.axes", d->planar ? 3 : 7);
    rel_put3(r, "d.velocity", rel_vary(d, -0.1, 0.1), rel_vary(d, -0.1, 0.1), 0);
    return 1;
}
static int rel_feed(rel_draw *d) {
    const double radius[1] = {0.5*d->R}, amount[1] = {4};
    rel_op *f;
    if (d->periodic == 7) return 0;
    f = rel_add(d, REL_FEED, 0);
    rel_put(f, "material", rel_stuff(d));
    rel_put(f, "class_count", 1);
    rel_list(d, f, "radius", radius, 1);
    rel_list(d, f, "amount", amount, 1);
    rel_put(f, "limited", 1);
    rel_put(f, "rate", rel_vary(d, 200, 3000));
    if (d->planar) rel_put_box(f, "box", -d->a/3, 0.7*d->h, -d->R, d->a/3, 0.9*d->h, d->R);
    else rel_put_box(f, "box", -d->a/3, -d->a/3, 0.8*d->h, d->a/3, d->a/3, 0.95*d->h);
    return 1;
}
static int rel_outlet(rel_draw *d) {
    rel_op *o = rel_add(d, REL_OUTLET, 0);
    if (d->planar) rel_put_box(o, "box", -d->a/2, 0, -d->R, d->a/2, d->h/3, d->R);
    else rel_put_box(o, "box", -d->a/2, -d->a/2, 0, d->a/2, d->a/2, d->h/4);
    if (rel_chance(d->r, 0.4)) rel_put(o, "keep", 1);
    return 1;
}
static int rel_average(rel_draw *d) {
    rel_op *f = rel_add(d, REL_FIELD, 0);
    if (d->planar) { rel_put_box(f, "box", -d->a, 0, -d->R, d->a, d->h, d->R); rel_put3(f, "cells", 2, 2, 1); }
    else { rel_put_box(f, "box", -d->a, -d->a, 0, d->a, d->a, d->h); rel_put3(f, "cells", 2, 2, 2); }
    rel_put(f, "interval", 1e-4);
    if (rel_chance(d->r, 0.5)) rel_put(f, "stress", 1);
    return 1;
}
static int rel_cell(rel_draw *d) {
    rel_op *c;
    if (d->periodic != (d->planar ? 3 : 7)) return 0;
    c = rel_add(d, REL_CELL, rel_chance(d->r, 0.3) ? rel_when(d) : 0);
    rel_put3(c, "rate", rel_vary(d, -2, 2), rel_vary(d, -2, 2), 0);
    return 1;
}
#include "draw_more.h"

#include "draw_services.h"
#include "draw_later.h"
/* ---- the rows, in the order in which they are tried ---- */
typedef struct rel_feature {
    const char *name;
    int group, must;                           /* 0: no group */
    double chance;                             /* of a row without `must` */
    int (*add)(rel_draw *d);
    int acts;                                  /* what must have happened: see rel_acted */
} rel_feature;
enum { REL_ACTS_ALWAYS, REL_ACTS_CONTACT, REL_ACTS_WALL, REL_ACTS_FED, REL_ACTS_GONE, REL_ACTS_TOOK };
static const rel_feature rel_features[] = {
    {"springs", 1, 1, 0, rel_springs, REL_ACTS_CONTACT}, {"impulses", 1, 1, 0, rel_impulses, REL_ACTS_CONTACT},
    {"planar", 0, 0, 0.2, rel_planar, 0},
    {"linear", 2, 0, 0.2, rel_linear, 1}, {"hysteretic", 2, 0, 0.2, rel_hysteretic, 1},
        {"own law", 2, 0, 0.15, rel_law, 1},
    REL_ROWS_LAWS
    {"no tangent", 3, 0, 0.05, rel_no_tangent, 1}, {"viscous", 3, 0, 0.1, rel_viscous, 1},
    {"step friction", 3, 0, 0.1, rel_step_law, 1}, {"Mindlin", 3, 0, 0.1, rel_mindlin, 1},
    {"Mindlin rescaled", 3, 0, 0.1, rel_rescaled, 1},
    {"constant rolling", 4, 0, 0.2, rel_roll_constant, 1}, {"EPSD rolling", 4, 0, 0.2, rel_roll_epsd, 1},
    {"clipped", 5, 0, 0.15, rel_clipped, 1}, {"compensated", 5, 0, 0.15, rel_compensated, 1},
    {"elastic load", 6, 0, 0.1, rel_load_elastic, 1}, {"magnitude load", 6, 0, 0.1, rel_load_magnitude, 1},
    {"spring slider", 7, 0, 0.1, rel_slider_spring, 1}, {"remainder slider", 7, 0, 0.1, rel_slider_remainder, 1},
    {"forward Euler", 8, 0, 0.08, rel_forward_euler, 0}, {"symplectic Euler", 8, 0, 0.1, rel_symplectic_euler, 0},
    {"position Verlet", 8, 0, 0.1, rel_position_verlet, 0}, {"leapfrog", 8, 0, 0.1, rel_leapfrog, 0},
    {"Jacobi", 9, 0, 0.15, rel_jacobi, 1}, {"APGD", 9, 0, 0.15, rel_apgd, 1}, {"spectral", 9, 0, 0.15, rel_spectral, 1},
    {"convex cone", 0, 0, 0.2, rel_convex, 1}, {"cold start", 0, 0, 0.2, rel_cold, 1},
    {"Fincham", 10, 0, 0.1, rel_fincham, 0}, {"NO_SQUISH", 10, 0, 0.1, rel_no_squish, 0},
    {"chord overlap", 11, 0, 0.1, rel_chord, 1}, {"normal overlap", 11, 0, 0.1, rel_normal_overlap, 1},
    {"separate clusters", 0, 0, 0.15, rel_separate, 1}, {"orientations", 0, 0, 0.1, rel_followed, 0},
    {"ledger", 0, 0, 0.3, rel_ledger_on, 0},
    {"all pairs", 12, 0, 0.08, rel_search_pairs, 0}, {"linked list", 12, 0, 0.1, rel_search_list, 0},
    {"levels", 12, 0, 0.1, rel_search_levels, 0}, {"bins", 12, 0, 0.1, rel_search_bins, 0},
    {"no skin", 13, 0, 0.1, rel_skin_none, 0}, {"narrow skin", 13, 0, 0.1, rel_skin_narrow, 0},
    {"wide skin", 13, 0, 0.1, rel_skin_wide, 0},
    {"force", 14, 0, 0.1, rel_drag, 0}, {"body force", 14, 0, 0.1, rel_swirl, 0}, {"growth", 0, 0, 0.08, rel_growth, 0},
    {"numbers", 0, 0, 0.1, rel_numbers, 0},
    REL_ROWS_WORLD
    {"gravity", 15, 0, 0.5, rel_gravity, 0}, {"tilted gravity", 15, 0, 0.3, rel_gravity_tilted, 0},
    {"material", 16, 1, 0, rel_material, 0}, {"two materials", 0, 0, 0.3, rel_two_materials, 0},
    {"stiffness", 0, 0, 0.2, rel_stiffness, 1}, {"rolling friction", 0, 0, 0.25, rel_rolling, 1},
    {"static friction", 0, 0, 0.15, rel_static, 1}, {"ignored pair", 0, 0, 0.2, rel_ignored, 0},
    {"cohesion", 0, 0, 0.15, rel_cohesion, 1}, {"compliance", 0, 0, 0.1, rel_compliance, 1},
    {"spinning friction", 0, 0, 0.15, rel_spinning, 1},
    REL_ROWS_MATERIALS
    {"spheres", 17, 0, 0.5, rel_spheres, 1}, {"small spheres", 0, 0, 0.2, rel_spheres_small, 1},
    {"ellipsoids", 0, 0, 0.25, rel_ellipsoid, 1}, {"clusters of one", 0, 0, 0.1, rel_cluster_one, 1},
    {"clusters", 0, 0, 0.25, rel_cluster_many, 1}, {"cubes", 18, 0, 0.25, rel_cube, 1},
        {"rocks", 18, 0, 0.2, rel_rock, 1},
    {"polygons", 0, 0, 0.4, rel_polygon, 1}, {"unions", 0, 0, 0.15, rel_union, 1},
    REL_ROWS_SHAPES
    {"planes", 19, 1, 0, rel_planes, REL_ACTS_WALL}, {"flat mesh", 19, 1, 0, rel_mesh_flat, REL_ACTS_WALL},
    {"bumpy mesh", 19, 1, 0, rel_mesh_bumpy, REL_ACTS_WALL}, {"profile", 19, 1, 0, rel_profile, REL_ACTS_WALL},
    {"cylinder", 19, 1, 0, rel_cylinder, REL_ACTS_WALL}, {"revolved", 19, 1, 0, rel_revolved, REL_ACTS_WALL},
    {"cone", 19, 1, 0, rel_cone, REL_ACTS_WALL}, {"wall of grains", 19, 1, 0, rel_grains, REL_ACTS_WALL},
    {"sieve", 19, 1, 0, rel_sieve, REL_ACTS_WALL}, {"periodic floor", 19, 1, 0, rel_periodic_floor, REL_ACTS_WALL},
    {"periodic", 19, 1, 0, rel_periodic_all, 0}, {"open", 19, 1, 0, rel_open, 0},
    REL_ROWS_CONTAINERS
    REL_ROWS_WALLS
    {"bodies", 20, 1, 0, rel_fill, 0},
    {"translating", 0, 0, 0.12, rel_translating, REL_ACTS_WALL}, {"rotating", 0, 0, 0.12, rel_rotating, REL_ACTS_WALL},
    {"oscillating", 0, 0, 0.12, rel_oscillating, REL_ACTS_WALL},
        {"user motion", 0, 0, 0.05, rel_nodding, REL_ACTS_WALL},
    {"servo", 0, 0, 0.1, rel_servo, 0}, {"belt", 0, 0, 0.1, rel_belt, REL_ACTS_WALL},
    {"fixed body", 0, 0, 0.15, rel_fixed, 0}, {"kick", 0, 0, 0.1, rel_kicked, 0},
        {"removal", 0, 0, 0.1, rel_removed, REL_ACTS_GONE},
    {"new radius", 0, 0, 0.1, rel_resized, 0}, {"gravity later", 0, 0, 0.1, rel_gravity_later, 0},
    {"point joint", 0, 0, 0.15, rel_joint_point, 0}, {"hinge", 0, 0, 0.15, rel_joint_hinge, 0},
        {"motor", 0, 0, 0.1, rel_motor, 0},
    {"rail", 0, 0, 0.1, rel_rail, 0}, {"feed", 0, 0, 0.15, rel_feed, REL_ACTS_FED},
        {"outlet", 0, 0, 0.1, rel_outlet, 0},
    {"average", 0, 0, 0.1, rel_average, 0}, {"cell", 0, 0, 0.4, rel_cell, 0},
    {"wall removed", 0, 0, 0.08, rel_wall_gone, 0},
    REL_ROWS_LATER, REL_SERVICE_FEATURES,
    {"second motion", 0, 0, 0.4, rel_second_motion, REL_ACTS_WALL}, {"fixed joint", 0, 0, 0.2, rel_joint_fixed, 0},
    {"late average", 0, 0, 0.5, rel_average_late, 0}, {"bar", 0, 0, 0.4, rel_bar, 0},
    {"pair later", 0, 0, 0.15, rel_pair_later, REL_ACTS_CONTACT},
    {"sheet", 0, 0, 0.05, rel_sheet, REL_ACTS_WALL}, {"laid cube", 0, 0, 0.4, rel_laid, 0}
};
enum { REL_ROWS = (int)(sizeof rel_features/sizeof *rel_features) };

static int rel_row(const char *name) {
    int i;
    for (i = 0; i < REL_ROWS && strcmp(rel_features[i].name, name); i++) continue;
    return i;
}
#include "rules.h"

enum { REL_WORK = 3000, REL_LEAST_STEPS = 30 };
/* Shortens a scene whose steps are expensive: many bodies, shapes, sweeps, or a new list in every step. */
static void rel_limit_work(rel_scene *s, int attempt) {
    double work = 0;
    int i, steps;
    for (i = 0; i < s->count; i++)
        if (s->op[i].call == REL_A_BODY) work += rel_sets(&s->op[i], "shape") ? 4 : 1;
    if (rel_sets(&s->op[0], "response")) work *= 8;
    if (rel_sets(&s->op[0], "growth") && !rel_sets(&s->op[0], "growth_interval")) work *= 4;
    steps = (int)(REL_WORK*(1 + attempt)/(work + 1));
    if (steps < REL_LEAST_STEPS) steps = REL_LEAST_STEPS;
    if (steps >= s->steps) return;
    for (i = 1; i < s->count; i++)
        if (s->op[i].step) s->op[i].step = 1 + (s->op[i].step - 1)*(steps - 1)/s->steps;
    s->steps = steps;
}

/* Draws a scene from a seed; attempt: how often nothing happened in what was drawn from this seed. The rows that it
   shall have are the same in all attempts. Returns 0 if it has no bodies. */
static int rel_draw_again(rel_scene *s, uint64_t seed, int attempt) {
    unsigned char chosen[REL_ROWS];
    rel_rng r;
    rel_draw d;
    int i, k, group = 0;
    r.s = seed ^ 0x3c6ef372fe94f82au;
    rel_choose(&r, chosen);
    r.s = seed + (uint64_t)attempt*0x9e3779b97f4a7c15u;
    memset(s, 0, offsetof(rel_scene, op));
    memset(&d, 0, sizeof d);
    s->seed = seed;
    s->steps = 120 + rel_below(&r, 400);
    d.s = s;
    d.r = &r;
    d.attempt = attempt;
    d.R = rel_between(&r, 0.7e-3, 1.5e-3);
    d.a = d.R*rel_between(&r, 4.5, 6.5);
    d.h = 2*d.a;
    rel_add(&d, REL_WORLD, 0);
    rel_put(rel_the_world(&d), "threads", 1);
    rel_put(rel_the_world(&d), "impact_speed", 0.5);
    for (i = 0; i < REL_ROWS; i++) {
        const rel_feature *f = &rel_features[i];
        d.feature = i;
        if (!d.shapes && rel_features[i].group == 19) rel_spheres(&d);
        if (f->must) {                         /* all rows of the group follow: one of those that suit */
            if (f->group == group) continue;
            for (k = i; k < REL_ROWS && rel_features[k].group == f->group; k++) continue;
            for (group = f->group;;) {
                int pick = i + rel_below(&r, k - i), j, some = 0;
                for (j = i; j < k; j++) if (chosen[j]) { pick = j; some++; }
                d.feature = pick;
                if ((some || rel_fits(chosen, pick)) && rel_fits(s->has, pick) &&
                    rel_features[pick].add(&d)) { s->has[pick] = 1; break; }
                if (k - i == 1) return 0;
                for (j = i; j < k && some; j++) chosen[j] = 0;         /* it does not suit */
            }
            continue;
        }
        if (!rel_fits(chosen, i) || !rel_fits(s->has, i) || !rel_has_needed(s->has, i)) continue;
        if (!chosen[i] && !rel_chance(&r, f->chance)) continue;
        if (f->add(&d)) s->has[i] = 1;
    }
    rel_limit_work(s, attempt);
    return 1;
}
/* What the ops of a row have written or recorded: bytes, contacts, or the number of calls. */
static long rel_taken(const rel_run *r, int feature) {
    long n = 0;
    int i;
    for (i = 0; i < r->s->count; i++) if (r->s->op[i].feature == feature) n += r->took[i];
    return n;
}
static int rel_draw_scene(rel_scene *s, uint64_t seed) { return rel_draw_again(s, seed, 0); }
static int rel_acted(const rel_run *r, int feature) {
    switch (rel_features[feature].acts) {
    case REL_ACTS_CONTACT: return r->contacts + r->wall_contacts > 0;
    case REL_ACTS_WALL: return r->wall_contacts > 0;
    case REL_ACTS_FED: return r->counts.inserted > (uint64_t)rel_bodies(r->s);
    case REL_ACTS_TOOK: return rel_taken(r, feature) > 0;
    case REL_ACTS_GONE: return r->counts.removed > 0;
    default: return 1;
    }
}
#endif
