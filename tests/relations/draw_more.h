/* draw_more.h - more rows for draw.h: laws of one's own and shipped ones, numbers on bodies, kinds of feeds, outlets,
   sieves, motions, rails, cells and averages. Many of them change a call that an earlier row has added: they need that
   row (rules.h). */
#ifndef REL_DRAW_MORE_H
#define REL_DRAW_MORE_H

/* Is a field set? */
static int rel_sets(const rel_op *op, const char *name) {
    const int f = rel_field_of(op->call, name);
    int i;
    for (i = 0; i < op->count; i++) if (op->set[i].field == f) return 1;
    return 0;
}
/* The last op of a call; null: none. */
static rel_op *rel_last(rel_draw *d, int call) {
    int i;
    for (i = d->s->count - 1; i >= 0; i--) if (d->s->op[i].call == call) return &d->s->op[i];
    return 0;
}
/* A row that sets one field of the last op of a call. */
#define REL_MORE(function, call, field, value) \
    static int function(rel_draw *d) { \
        rel_op *op = rel_last(d, call); \
        if (op) rel_put(op, field, value); \
        return op != 0; \
    }

/* ---- laws ---- */
typedef struct rel_law_row {
    const char *law, *rows, *rate, *user;      /* names of codes.h; null: none */
    int memory, vectors, who;
    double stiffness, range;                   /* N/m; m */
    int normal;
} rel_law_row;
static int rel_own_law(rel_draw *d, const rel_law_row *l) {
    rel_op *w = rel_the_world(d);
    if (d->impulses) return 0;
    rel_put(w, "law", rel_code_of(l->law));
    if (l->rows) rel_put(w, "law_rows", rel_code_of(l->rows));
    if (l->rate) rel_put(w, "law_rate", rel_code_of(l->rate));
    if (l->user) rel_put(w, "law_user", rel_datum_of(l->user));
    rel_put(w, "law_memory", l->memory);
    rel_put(w, "law_vectors", l->vectors);
    if (l->stiffness > 0) rel_put(w, "law_stiffness", l->stiffness);
    if (l->range > 0) rel_put(w, "law_range", l->range);
    if (l->normal) rel_put(w, "normal_law", l->normal);
    if (!l->who) return 1;
    rel_put(w, "law_who", 1);
    rel_put(w, "body_reals", rel_text_of("heat charge"));
    return 1;
}
#define REL_LAW(function, ...) \
    static int function(rel_draw *d) { const rel_law_row l = {__VA_ARGS__}; return rel_own_law(d, &l); }
REL_LAW(rel_law_rows, "law_inline", "law_in_rows", 0, 0, 3, 1, 0, 0, 0, DEM_NORMAL_LINEAR)
REL_LAW(rel_law_far, "law_far", 0, 0, "far_pull", 3, 1, 0, 0, 0.3*d->R, 0)
REL_LAW(rel_law_warm, "law_warm", 0, "warm_rate", 0, 3, 1, 1, 0, 0, 0)
/* bond_own breaks when it is stretched by 1 %, which is before the range ends */
REL_LAW(rel_law_bond, "bond_law", 0, 0, "bond_own", 8, 2, 1, 4e3, 2e-4, DEM_NORMAL_LINEAR)
REL_LAW(rel_law_capillary, "capillary_law", 0, 0, "capillary_own", 5, 1, 0, 0, 2e-4, 0)
REL_LAW(rel_law_charge, "charge_law", 0, 0, "charge_own", 5, 1, 1, 0, 0, 0)
REL_LAW(rel_law_dmt, "dmt_law", 0, 0, "dmt_own", 4, 1, 0, 0, 0, 0)
REL_LAW(rel_law_heat, "heat_law", 0, "heat_rate", "heat_own", 4, 1, 1, 0, 0, 0)
REL_LAW(rel_law_jkr, "jkr_law", 0, 0, "jkr_own", 6, 1, 0, 0, 1e-5, 0)
REL_LAW(rel_law_luding, "luding_law", 0, 0, "luding_own", 6, 1, 0, 5e4, 0, DEM_NORMAL_LINEAR)
REL_LAW(rel_law_viscoelastic, "viscoelastic_law", 0, 0, "viscoelastic_own", 4, 1, 0, 0, 0, 0)
REL_LAW(rel_law_walton, "walton_braun_law", 0, 0, "walton_braun_own", 6, 1, 0, 5e4, 0, DEM_NORMAL_LINEAR)
static int rel_reach_radii(rel_draw *d) {
    rel_put(rel_the_world(d), "law_range_radii", rel_vary(d, 0.05, 0.2));
    return 1;
}
static int rel_named_memory(rel_draw *d) {
    if (!rel_sets(rel_the_world(d), "law")) return 0;
    rel_put(rel_the_world(d), "law_memory_names", rel_text_of("x y z"));
    return 1;
}
static int rel_bonds(rel_draw *d) { rel_put(rel_add(d, REL_BONDS, 0), "gap", 1.5e-4); return 1; }

/* ---- the world ---- */
REL_OPTION(rel_tangent_spring, "tangent_law", DEM_TANGENT_SPRING, !d->impulses)
REL_OPTION(rel_roll_none, "rolling_law", DEM_ROLLING_NONE, !d->impulses)
REL_OPTION(rel_roll_step, "rolling_law", DEM_ROLLING_STEP, !d->impulses)
REL_OPTION(rel_mill_rules, "convention", DEM_CONVENTION_MILL, !d->impulses)
REL_OPTION(rel_grid, "search", DEM_SEARCH_GRID, 1)
REL_OPTION(rel_groups_of_16, "domain_bodies", 16, 1)
REL_OPTION(rel_groups_of_4, "domain_bodies", 4, 1)
REL_OPTION(rel_large_steps, "allow_large_dt", 1, 1)
REL_OPTION(rel_unsolved, "unsolved_stops", 1, d->impulses)
REL_OPTION(rel_impulse_range, "law_range", 0.3*d->R, d->impulses)
REL_OPTION(rel_overlap_stop, "overlap_stop", 0.4, 1)
REL_OPTION(rel_growth_seldom, "growth_interval", rel_vary(d, 1e-5, 5e-4), 1)
REL_OPTION(rel_named_groups, "groups", rel_text_of("one two"), 1)
static int rel_users(rel_draw *d) {
    rel_put(rel_the_world(d), "force", rel_code_of("drag_of"));
    rel_put(rel_the_world(d), "force_user", rel_datum_of("some_rate"));
    return 1;
}
static int rel_growth_user(rel_draw *d) {
    rel_put(rel_the_world(d), "growth", rel_code_of("grow_of"));
    rel_put(rel_the_world(d), "growth_user", rel_datum_of("some_rate"));
    return 1;
}
static int rel_numbers_user(rel_draw *d) {
    rel_put(rel_the_world(d), "body_reals_fn", rel_code_of("numbers_of"));
    rel_put(rel_the_world(d), "body_reals_user", rel_datum_of("some_rate"));
    return 1;
}
/* ---- materials ---- */
static int rel_all_materials(rel_draw *d, const char *field, double x) {
    int i;
    for (i = 0; i < d->materials; i++) rel_put(&d->s->op[d->material[i]], field, x);
    return 1;
}
static int rel_ratio(rel_draw *d) { return rel_all_materials(d, "stiffness_ratio", rel_vary(d, 0.3, 1)); }
static int rel_unloading(rel_draw *d) {
    rel_all_materials(d, "restitution", 0);
    return rel_all_materials(d, "stiffness_unloading", rel_vary(d, 4000, 8000));
}
static int rel_adhesion(rel_draw *d) { return rel_all_materials(d, "stiffness_adhesion", rel_vary(d, 100, 400)); }
#define REL_PAIR_ROW(function, field, low, high) \
    static int function(rel_draw *d) { rel_put(rel_pair_of(d), field, rel_vary(d, low, high)); return 1; }
REL_PAIR_ROW(rel_pair_friction, "friction", 0, 1)
REL_PAIR_ROW(rel_pair_restitution, "restitution", 0.3, 0.9)
REL_PAIR_ROW(rel_pair_rolling, "rolling_friction", 0.01, 0.3)
REL_PAIR_ROW(rel_pair_normal, "normal_damping", 1e-3, 1e-2)
REL_PAIR_ROW(rel_pair_tangent, "tangent_damping", 0, 2)
REL_PAIR_ROW(rel_pair_ratio, "stiffness_ratio", 0.3, 1)
REL_PAIR_ROW(rel_pair_stiffness, "stiffness", 500, 2500)
REL_PAIR_ROW(rel_pair_adhesion, "stiffness_adhesion", 50, 400)
static int rel_pair_moduli(rel_draw *d) {
    rel_op *p = rel_pair_of(d);
    rel_put(p, "young_eff", rel_vary(d, 1e6, 5e6));
    rel_put(p, "shear_eff", rel_vary(d, 3e5, 1e6));
    return 1;
}
static int rel_pair_static(rel_draw *d) {
    rel_op *p = rel_pair_of(d);
    rel_put(p, "friction", 0.2);
    rel_put(p, "friction_static", rel_vary(d, 0.3, 0.8));
    return 1;
}
/* ---- shapes ---- */
static int rel_cluster_union(rel_draw *d) {
    rel_op *s = rel_last(d, REL_CLUSTER);
    if (!s) return 0;
    rel_put(s, "mass", DEM_CLUSTER_UNION);
    rel_put(s, "rays", 32 + rel_any(d, 64));
    return 1;
}
static int rel_cluster_alike(rel_draw *d) {    /* spheres of one radius: the list is absent */
    rel_op *s = rel_last(d, REL_CLUSTER);
    int j, k;
    if (!s) return 0;
    for (j = k = 0; j < s->count; j++)
        if (s->set[j].field != rel_field_of(REL_CLUSTER, "radii")) s->set[k++] = s->set[j];
    s->count = k;
    rel_put(s, "radius", 0.5*d->R);
    return 1;
}
static int rel_cluster_given(rel_draw *d) {
    const double v = 2*d->R*d->R*d->R, i = 0.3*v*d->R*d->R, inertia[6] = {i, 1.2*i, 1.1*i, 0, 0, 0};
    rel_op *s = rel_last(d, REL_CLUSTER);
    if (!s) return 0;
    rel_put(s, "mass", DEM_CLUSTER_GIVEN);
    rel_put(s, "volume", v);
    rel_put3(s, "centre", 0.05*d->R, 0, -0.03*d->R);
    rel_list(d, s, "inertia", inertia, 6);
    return 1;
}
/* A union of pieces that are shapes of their own, side by side, each rotated. */
static int rel_pieces_of(rel_draw *d, int call, int count) {
    double of[3], at[9] = {0}, q[12];
    rel_op *s = 0;
    int i, k;
    for (i = 0; i < count; i++) {
        if (call == REL_ELLIPSOID) {
            s = rel_add(d, REL_ELLIPSOID, 0);
            rel_put3(s, "axes", 0.6*d->R, rel_vary(d, 0.3, 0.6)*d->R, rel_vary(d, 0.3, 0.5)*d->R);
        } else {
            double x[24];
            int c;
            s = rel_add(d, call, 0);
            for (c = 0; c < 8; c++)
                for (k = 0; k < 3; k++) x[3*c + k] = (c >> k & 1 ? 0.4 : -0.4)*rel_vary(d, 0.8, 1)*d->R;
            rel_list(d, s, "points", x, 24);
        }
        of[i] = rel_index(d, s);
        at[3*i] = (i - (count - 1)/2.0)*0.6*d->R;
        for (k = 0; k < 4; k++) q[4*i + k] = rel_vary(d, k ? -1 : 0.2, 1);
    }
    s = rel_add(d, REL_UNION, 0);
    rel_list(d, s, "shapes", of, count);
    rel_list(d, s, "positions", at, 3*count);
    rel_list(d, s, "orientations", q, 4*count);
    return rel_shape(d, rel_index(d, s), 1.6*d->R);
}
static int rel_union_balls(rel_draw *d) { return d->planar ? 0 : rel_pieces_of(d, REL_ELLIPSOID, 2 + rel_any(d, 2)); }
static int rel_union_blocks(rel_draw *d) { return d->planar ? 0 : rel_pieces_of(d, REL_POLYHEDRON, 2 + rel_any(d, 2)); }
static int rel_polygon_concave(rel_draw *d) {
    const double R = d->R, x[12] = {-R, -R/2, R, -R/2, R, R/2, 0.3*R, R/2, 0.3*R, 0, -R, 0};
    rel_op *s;
    if (!d->planar) return 0;
    s = rel_add(d, REL_POLYGON, 0);
    rel_list(d, s, "corners", x, 12);
    return rel_shape(d, rel_index(d, s), 1.2*R);
}
static int rel_scaled_bodies(rel_draw *d) { return d->scaled = 1; }
/* ---- walls ---- */
static int rel_outflow(rel_draw *d) {          /* a floor without sides; bodies leave */
    rel_put_box(rel_the_world(d), "domain", -d->a, d->planar ? -d->R : -d->a, d->planar ? -d->R : -d->R, d->a,
                d->planar ? d->h : d->a, d->planar ? d->R : d->h);
    rel_put3(rel_the_world(d), "boundary", DEM_BOUNDARY_OUTFLOW, d->planar ? 0 : DEM_BOUNDARY_OUTFLOW, 0);
    rel_plane_at(d, 0, 0, 0, 0, d->planar ? 1 : 0, d->planar ? 0 : 1);
    return 1;
}
/* The floor consists of two closed boxes side by side. */
static int rel_boxes(rel_draw *d) {
    static const double face[36] = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4, 1, 2, 6, 1, 6, 5, 2, 3, 7, 2,
        7, 6, 3, 0, 4, 3, 4, 7};
    const double a = rel_vary(d, 1.5*d->a, 1.5*d->a), seam = rel_vary(d, -d->a, d->a);     /* few digits */
    double x[24];
    int i, k;
    if (d->planar || d->periodic) return 0;
    for (k = 0; k < 2; k++) {
        rel_op *m = rel_add(d, REL_MESH, 0);
        for (i = 0; i < 8; i++) {
            x[3*i] = (i + 1)/2%2 ? (k ? a : seam) : k ? seam : -a;
            x[3*i + 1] = i/2%2 ? a : -a;
            x[3*i + 2] = i/4 ? 0 : -3e-3;
        }
        rel_put(m, "material", rel_stuff(d));
        rel_list(d, m, "vertices", x, 24);
        rel_list(d, m, "triangles", face, 36);
        rel_wall(d, m);
    }
    rel_sides(d);
    return 1;
}
static int rel_rod(rel_draw *d) {              /* in the floor, of which grains see the upper side */
    rel_op *c = rel_add(d, REL_CYLINDER, 0);
    rel_put(c, "material", rel_stuff(d));
    rel_put3(c, "point", 0, 0, -0.6*d->R);
    rel_put3(c, "axis", 1, 0, 0);
    rel_put(c, "radius", 0.8*d->R);
    rel_put(c, "inside", 0);
    rel_wall(d, c);
    return d->bumps = 1;
}
REL_MORE(rel_fractions, REL_PROFILE, "rule", DEM_EDGE_FRACTION)
REL_MORE(rel_sieve_bars, REL_SIEVE, "kind", DEM_SIEVE_BARS)
REL_MORE(rel_sieve_square, REL_SIEVE, "kind", DEM_SIEVE_SQUARE)
REL_MORE(rel_sieve_round, REL_SIEVE, "kind", DEM_SIEVE_ROUND)
REL_MORE(rel_sieve_reduced, REL_SIEVE, "kind", DEM_SIEVE_REDUCED)
static int rel_sieve_slots(rel_draw *d) {
    rel_op *g = rel_last(d, REL_SIEVE);
    if (!g) return 0;
    rel_put(g, "kind", DEM_SIEVE_SLOTS);
    rel_put(g, "length", 4*d->R);
    return 1;
}
REL_MORE(rel_sieve_thick, REL_SIEVE, "thickness", rel_vary(d, 0.2, 0.6)*d->R)
REL_MORE(rel_sieve_lift, REL_SIEVE, "lift", rel_vary(d, 0.8, 1)*d->R)
REL_MORE(rel_sieve_staggered, REL_SIEVE, "staggered", 1)
REL_MORE(rel_sieve_disc, REL_SIEVE, "radius", 1.2*d->a)
REL_MORE(rel_sieve_model, REL_SIEVE, "model", 1 + rel_any(d, 2))
REL_MORE(rel_sieve_clearance, REL_SIEVE, "clearance", rel_vary(d, 0.1, 0.9))
/* ---- motions ---- */
static int rel_table(rel_draw *d) {
    const double s = 1/sqrt(1.01), x[9] = {0, 0, 0, 0.1*d->R, 0.2*d->R, d->planar ? 0 : 0.1*d->R, 0, 0, 0};
    const double t[3] = {0, rel_vary(d, 5e-4, 3e-3), 6e-3}, load[3] = {0, 0, 0};
    const double q[12] = {1, 0, 0, 0, s, 0, 0, 0.1*s, 1, 0, 0, 0};
    rel_op *m = rel_move(d, DEM_MOTION_TABLE);
    if (!m) return 0;
    m->count = 0;
    m->call = REL_TABLE;
    rel_put(m, "wall", d->wall[0]);
    rel_put(m, "kind", DEM_MOTION_TABLE);
    rel_list(d, m, "times", t, 3);
    rel_list(d, m, "places", x, 9);
    rel_list(d, m, "turns", q, 12);
    rel_list(d, m, "loads", load, 3);
    return 1;
}
REL_MORE(rel_table_again, REL_TABLE, "table_repeats", 1)
static rel_op *rel_last_kind(rel_draw *d, int kind) {
    int i, j;
    for (i = d->s->count - 1; i >= 0; i--)
        for (j = 0; j < d->s->op[i].count && d->s->op[i].call == REL_MOTION; j++)
            if (d->s->op[i].set[j].field == rel_field_of(REL_MOTION, "kind") && (int)d->s->op[i].set[j].v[0] == kind)
                return &d->s->op[i];
    return 0;
}
static int rel_user_motion(rel_draw *d) {
    rel_op *m = rel_last_kind(d, DEM_MOTION_USER);
    if (m) { rel_put(m, "function", rel_code_of("nod_of")); rel_put(m, "user", rel_datum_of("nod_by")); }
    return m != 0;
}
static int rel_phase(rel_draw *d) {
    rel_op *m = rel_last_kind(d, DEM_MOTION_OSCILLATING);
    if (m) { rel_put(m, "phase", rel_vary(d, 0.2, 3)); rel_put(m, "ramp", rel_vary(d, 1e-4, 1e-2)); }
    return m != 0;
}
static int rel_servo_stress(rel_draw *d) {
    rel_op *m = rel_last_kind(d, DEM_MOTION_SERVO);
    if (m) { rel_put(m, "load", rel_vary(d, 5, 100)); rel_put(m, "area", 4*d->a*d->a); }
    return m != 0;
}
static int rel_servo_travel(rel_draw *d) {
    rel_op *m = rel_last_kind(d, DEM_MOTION_SERVO);
    if (m) rel_put(m, "travel", rel_vary(d, 0.2, 1)*d->R);
    return m != 0;
}
static int rel_servo_ramp(rel_draw *d) {
    rel_op *m = rel_last_kind(d, DEM_MOTION_SERVO);
    if (m) { rel_put(m, "ramp", rel_vary(d, 1e-4, 2e-3)); rel_put(m, "start", rel_vary(d, 0, 1e-3)); }
    return m != 0;
}
static int rel_servo_low(rel_draw *d) {        /* presses from the first steps on */
    rel_op *p = rel_last(d, REL_PLANE);
    if (!rel_last_kind(d, DEM_MOTION_SERVO)) return 0;
    rel_put3(p, "point", 0, 0, d->top + 0.05*d->R);
    return 1;
}
static int rel_servo_table(rel_draw *d) {
    const double t[3] = {0, 1e-3, 2e-3}, load[3] = {1e-4, rel_vary(d, 1e-3, 1e-2), 2e-3}, x[9] = {0};
    const double q[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    rel_op *m = rel_last_kind(d, DEM_MOTION_SERVO);
    int j, k;
    if (!m) return 0;
    m->call = REL_TABLE;
    for (j = k = 0; j < m->count; j++)
        if (strcmp(rel_calls[REL_TABLE].fields[m->set[j].field].name, "d.load")) m->set[k++] = m->set[j];
    m->count = k;
    rel_list(d, m, "times", t, 3);
    rel_list(d, m, "places", x, 9);
    rel_list(d, m, "turns", q, 12);
    rel_list(d, m, "loads", load, 3);
    return 1;
}
/* ---- groups and selections ---- */
static int rel_members(rel_draw *d) {
    rel_op *g = rel_add(d, REL_GROUP, rel_chance(d->r, 0.3) ? rel_when(d) : 0);
    rel_put(g, "group", 1 + rel_any(d, 2));
    rel_put(g, "radius_max", rel_vary(d, 0.6, 1.2)*d->R);
    if (rel_chance(d->r, 0.3)) rel_put(g, "radius_min", 0.3*d->R);
    if (rel_chance(d->r, 0.3)) rel_put(g, "material", rel_stuff(d));
    if (rel_chance(d->r, 0.3)) rel_put(g, "shape", d->shape[0]);
    if (rel_chance(d->r, 0.2)) rel_put(g, "d.group.id", 1);
    return 1;
}
static rel_op *rel_pushed(rel_draw *d) {
    rel_op *k = rel_add(d, REL_PUSH, rel_when(d));
    rel_put3(k, "velocity", rel_vary(d, -0.2, 0.2), rel_vary(d, -0.2, 0.2), d->planar ? 0 : rel_vary(d, -0.2, 0.2));
    rel_put3(k, "spin", 0, 0, rel_vary(d, -20, 20));
    if (d->planar) rel_put_box(k, "region.box", -d->a, 0, -d->R, 0.3*d->a, d->h, d->R);
    else rel_put_box(k, "region.box", -d->a, -d->a, 0, 0.3*d->a, d->a, d->h);
    return k;
}
static int rel_push(rel_draw *d) { return rel_pushed(d) != 0; }
REL_MORE(rel_push_material, REL_PUSH, "material", rel_stuff(d))
REL_MORE(rel_push_group, REL_PUSH, "d.group.id", 1)
REL_MORE(rel_push_cylinder, REL_PUSH, "region.cylinder", d->planar ? 'z' : 'y')
REL_MORE(rel_push_shape, REL_PUSH, "shape", d->shape[0])
static int rel_push_radii(rel_draw *d) {
    rel_op *k = rel_last(d, REL_PUSH);
    if (!k) return 0;
    rel_put(k, "radius_min", 0.3*d->R);
    rel_put(k, "radius_max", rel_vary(d, 0.7, 1.3)*d->R);
    return 1;
}
static int rel_push_inside(rel_draw *d) {
    rel_op *k = rel_last(d, REL_PUSH);
    if (!k) return 0;
    rel_put(k, "region.inside", rel_code_of("inside_half"));
    if (rel_chance(d->r, 0.5)) rel_put(k, "region.user", rel_datum_of("nod_by"));
    return 1;
}
/* ---- joints and rails ---- */
static int rel_motor_torque(rel_draw *d) {
    if (!rel_join(d, DEM_JOINT_REVOLUTE, DEM_MOTOR_TORQUE)) return 0;
    rel_put(rel_last(d, REL_JOINT), "torque", rel_vary(d, -1e-7, 1e-7));
    return 1;
}
static int rel_joint_wall(rel_draw *d) {
    rel_op *j = rel_last(d, REL_JOINT);
    if (!j || !d->walls) return 0;
    rel_put(j, "b", -1);
    rel_put(j, "wall", d->wall[0]);
    return 1;
}
REL_MORE(rel_joint_collide, REL_JOINT, "collide", 1)
REL_MORE(rel_rail_one, REL_RAIL, "d.axes", 1 << rel_any(d, d->planar ? 2 : 3))
static int rel_rail_spin(rel_draw *d) {
    rel_op *r = rel_last(d, REL_RAIL);
    if (!r) return 0;
    rel_put(r, "d.axes", d->planar ? DEM_RAIL_X + DEM_RAIL_SPIN_Z :
            DEM_RAIL_ALL - (rel_chance(d->r, 0.5) ? DEM_RAIL_SPIN_X : 0));
    rel_put3(r, "d.spin", 0, 0, rel_vary(d, -20, 20));
    return 1;
}
static int rel_rail_wall(rel_draw *d) {
    rel_op *r = rel_last(d, REL_RAIL);
    if (!r || !d->walls) return 0;
    rel_put(r, "d.wall", d->wall[0]);
    return 1;
}
/* ---- feeds ---- */
static int rel_feed_classes(rel_draw *d) {
    const double radius[3] = {0.3*d->R, 0.4*d->R, 0.5*d->R}, amount[3] = {2, 2, 1};
    rel_op *f = rel_last(d, REL_FEED);
    if (!f) return 0;
    rel_put(f, "class_count", 3);
    rel_list(d, f, "radius", radius, 3);
    rel_list(d, f, "amount", amount, 3);
    return 1;
}
REL_MORE(rel_feed_endless, REL_FEED, "limited", 0)
static int rel_feed_mass(rel_draw *d) {
    rel_op *f = rel_last(d, REL_FEED);
    const int fields = rel_calls[REL_FEED].field_count, amount = rel_field_of(REL_FEED, "amount");
    const int rate = rel_field_of(REL_FEED, "rate");
    const double kg = 2000*d->R*d->R*d->R;
    int j, k;
    if (!f) return 0;
    rel_put(f, "by_mass", 1);
    for (j = 0; j < f->count; j++) {           /* the last two fields are amount and rate with these units */
        rel_set *v = &f->set[j];
        for (k = 0; k < v->count && v->field == amount; k++) d->s->pool[v->at + k] *= kg;
        if (v->field == rate) v->v[0] *= kg;
        if (v->field == amount || v->field == rate) v->field = fields - (v->field == amount ? 2 : 1);
    }
    return 1;
}
REL_MORE(rel_feed_round, REL_FEED, "round", 1)
REL_MORE(rel_feed_at_once, REL_FEED, "rate", 0)
REL_MORE(rel_feed_seed, REL_FEED, "seed", 1 + rel_any(d, 1000))
static int rel_feed_thrown(rel_draw *d) {
    rel_op *f = rel_last(d, REL_FEED);
    if (!f) return 0;
    rel_put3(f, "velocity", rel_vary(d, -0.2, 0.2), d->planar ? -0.5 : rel_vary(d, -0.2, 0.2), d->planar ? 0 : -0.5);
    rel_put(f, "spread", rel_vary(d, 0, 0.1));
    return 1;
}
static int rel_feed_window(rel_draw *d) {
    rel_op *f = rel_last(d, REL_FEED);
    if (!f) return 0;
    rel_put(f, "start", rel_vary(d, 0, 5e-4));
    rel_put(f, "end", rel_vary(d, 1e-3, 4e-3));
    return 1;
}
static int rel_feed_inside(rel_draw *d) {
    rel_op *f = rel_last(d, REL_FEED);
    if (!f) return 0;
    rel_put(f, "inside", rel_code_of("inside_half"));
    if (rel_chance(d->r, 0.5)) rel_put(f, "inside_user", rel_datum_of("nod_by"));
    return 1;
}
static int rel_feed_shapes(rel_draw *d) {
    rel_op *f = rel_last(d, REL_FEED);
    double of[3];
    int k;
    if (!f) return 0;
    for (k = 0; k < 3; k++) of[k] = d->shape[rel_any(d, d->shapes)];
    of[0] = d->shape[d->shapes - 1];
    rel_list(d, f, "shapes", of, 3);
    return 1;
}
static int rel_feed_materials(rel_draw *d) {
    rel_op *f = rel_last(d, REL_FEED);
    double of[1];
    if (!f) return 0;
    of[0] = d->material[d->materials - 1];
    rel_list(d, f, "materials", of, 1);
    return 1;
}
static int rel_feed_sizes(rel_draw *d) {
    static const int kinds[] = {DEM_SIZES_UNIFORM, DEM_SIZES_LOGNORMAL, DEM_SIZES_WEIBULL, DEM_SIZES_SIEVE_CURVE,
                                DEM_SIZES_NORMAL, DEM_SIZES_EXPONENTIAL};
    const double sieves[3] = {0.3*d->R, 0.4*d->R, 0.5*d->R}, passing[3] = {0.2, 0.6, 1};
    rel_op *f = rel_last(d, REL_FEED);
    const int kind = kinds[rel_any(d, 6)];
    if (!f) return 0;
    f->call = REL_FEED_SIZES;
    rel_put(f, "sizes.kind", kind);
    rel_put(f, "sizes.by_count", rel_any(d, 2));
    if (kind != DEM_SIZES_SIEVE_CURVE) { rel_put(f, "sizes.min", 0.3*d->R); rel_put(f, "sizes.max", 0.5*d->R); }
    if (kind == DEM_SIZES_LOGNORMAL || kind == DEM_SIZES_NORMAL) rel_put(f, "sizes.median", 0.4*d->R);
    if (kind == DEM_SIZES_LOGNORMAL) rel_put(f, "sizes.spread", 0.2);
    if (kind == DEM_SIZES_NORMAL) rel_put(f, "sizes.deviation", 0.05*d->R);
    if (kind == DEM_SIZES_WEIBULL || kind == DEM_SIZES_EXPONENTIAL) rel_put(f, "sizes.scale", 0.4*d->R);
    if (kind == DEM_SIZES_WEIBULL) rel_put(f, "sizes.modulus", 3);
    if (kind != DEM_SIZES_SIEVE_CURVE) return 1;
    rel_put(f, "sizes.count", 3);
    rel_list(d, f, "sizes.radius", sieves, 3);
    rel_list(d, f, "sizes.passing", passing, 3);
    return 1;
}
/* ---- outlets ---- */
REL_MORE(rel_outlet_beyond, REL_OUTLET, "beyond", 0.3*d->a)
REL_MORE(rel_outlet_material, REL_OUTLET, "material", rel_stuff(d))
REL_MORE(rel_outlet_times, REL_OUTLET, "residence_bin", 1e-4)
static int rel_outlet_frame(rel_draw *d) {
    rel_op *o = rel_last(d, REL_OUTLET);
    if (!o || !d->walls) return 0;
    rel_put(o, "frame", d->wall[0]);
    return 1;
}
static int rel_outlet_wanted(rel_draw *d) {
    rel_op *o = rel_last(d, REL_OUTLET);
    if (!o) return 0;
    rel_put(o, "wanted_min", 0.4*d->R);
    rel_put(o, "wanted_max", 0.9*d->R);
    return 1;
}
static int rel_outlet_classes(rel_draw *d) {
    const double radius[3] = {0.4*d->R, 0.7*d->R, d->R};
    rel_op *o = rel_last(d, REL_OUTLET);
    if (!o) return 0;
    rel_put(o, "class_count", 3);
    rel_list(d, o, "radius", radius, 3);
    return 1;
}
/* ---- averages ---- */
REL_MORE(rel_average_group, REL_FIELD, "d.group.id", 1)
REL_MORE(rel_average_width, REL_FIELD, "width", d->a)
REL_MORE(rel_average_variance, REL_FIELD, "variance", 1)
REL_MORE(rel_average_bodies, REL_FIELD, "bodies", 1)
REL_MORE(rel_average_material, REL_FIELD, "material", rel_stuff(d))
static int rel_average_window(rel_draw *d) {
    rel_op *f = rel_last(d, REL_FIELD);
    if (!f) return 0;
    rel_put(f, "start", rel_vary(d, 0, 5e-4));
    rel_put(f, "end", rel_vary(d, 6e-4, 3e-3));
    return 1;
}
static int rel_average_radii(rel_draw *d) {
    rel_op *f = rel_last(d, REL_FIELD);
    if (!f) return 0;
    rel_put(f, "radius_min", 0.3*d->R);
    rel_put(f, "radius_max", 0.9*d->R);
    return 1;
}
/* ---- cells ---- */
static int rel_cell_shear(rel_draw *d) {
    rel_op *c = rel_last(d, REL_CELL);
    if (!c) return 0;
    rel_put(c, "shear", rel_vary(d, -20, 20));
    return 1;
}
static int rel_cell_stress(rel_draw *d) {
    rel_op *c = rel_last(d, REL_CELL);
    if (!c) return 0;
    c->count = 0;                              /* an axis with rate_most has no rate */
    rel_put3(c, "stress", rel_vary(d, 10, 500), rel_vary(d, 10, 500), d->planar ? 0 : rel_vary(d, 10, 500));
    rel_put3(c, "rate_most", rel_vary(d, 1, 20), rel_any(d, 2) ? rel_vary(d, 1, 20) : 0,
             d->planar ? 0 : rel_vary(d, 1, 20));
    return 1;
}
static int rel_cell_later(rel_draw *d) {       /* other controls in the middle of the run */
    rel_op *c;
    if (!rel_last(d, REL_CELL)) return 0;
    c = rel_add(d, REL_CELL, rel_when(d));
    rel_put3(c, "rate", rel_vary(d, -5, 5), rel_vary(d, -5, 5), 0);
    return 1;
}
/* ---- the rows, which draw.h has at four places ---- */
#define REL_ROWS_LAWS \
    {"law by rows", 2, 0, 0.03, rel_law_rows, 1}, {"law across gaps", 2, 0, 0.03, rel_law_far, 1}, \
    {"law of numbers", 2, 0, 0.03, rel_law_warm, 1}, {"bonds", 2, 0, 0.03, rel_law_bond, 1}, \
    {"capillary", 2, 0, 0.03, rel_law_capillary, 1}, {"charge", 2, 0, 0.03, rel_law_charge, 1}, \
    {"DMT", 2, 0, 0.03, rel_law_dmt, 1}, {"heat", 2, 0, 0.03, rel_law_heat, 1}, {"JKR", 2, 0, 0.03, rel_law_jkr, 1}, \
    {"Luding", 2, 0, 0.03, rel_law_luding, 1}, {"viscoelastic", 2, 0, 0.03, rel_law_viscoelastic, 1}, \
    {"Walton-Braun", 2, 0, 0.03, rel_law_walton, 1}, {"range in radii", 0, 0, 0.3, rel_reach_radii, 1}, \
    {"named history", 0, 0, 0.1, rel_named_memory, 0}, {"spring", 3, 0, 0.03, rel_tangent_spring, 1}, \
    {"no rolling law", 4, 0, 0.03, rel_roll_none, 1}, {"step rolling", 4, 0, 0.03, rel_roll_step, 1}, \
    {"rules of the mill", 0, 0, 0.03, rel_mill_rules, 1},
#define REL_ROWS_WORLD \
    {"grid", 12, 0, 0.05, rel_grid, 0}, {"groups of 16", 30, 0, 0.1, rel_groups_of_16, 0}, \
    {"groups of 4", 30, 0, 0.1, rel_groups_of_4, 0}, {"large steps", 0, 0, 0.03, rel_large_steps, 0}, \
    {"unsolved stops", 0, 0, 0.03, rel_unsolved, 1}, {"impulses at a distance", 0, 0, 0.03, rel_impulse_range, 1}, \
    {"overlap stops", 0, 0, 0.03, rel_overlap_stop, 1}, {"growth at intervals", 0, 0, 0.2, rel_growth_seldom, 0}, \
    {"groups", 0, 0, 0.1, rel_named_groups, 0}, {"force with data", 14, 0, 0.03, rel_users, 0}, \
    {"growth with data", 0, 0, 0.2, rel_growth_user, 0}, {"numbers with data", 0, 0, 0.2, rel_numbers_user, 0},
#define REL_ROWS_MATERIALS \
    {"stiffness ratio", 0, 0, 0.04, rel_ratio, 1}, {"unloading stiffness", 0, 0, 0.2, rel_unloading, 1}, \
    {"adhesion", 31, 0, 0.2, rel_adhesion, 1}, {"pair friction", 32, 0, 0.03, rel_pair_friction, 1}, \
    {"pair restitution", 0, 0, 0.03, rel_pair_restitution, 1}, {"pair rolling", 0, 0, 0.03, rel_pair_rolling, 1}, \
    {"normal damping", 0, 0, 0.05, rel_pair_normal, 1}, {"tangent damping", 0, 0, 0.03, rel_pair_tangent, 1}, \
    {"pair stiffness ratio", 0, 0, 0.03, rel_pair_ratio, 1}, {"pair stiffness", 0, 0, 0.1, rel_pair_stiffness, 1}, \
    {"pair adhesion", 31, 0, 0.1, rel_pair_adhesion, 1}, {"pair moduli", 0, 0, 0.03, rel_pair_moduli, 1}, \
    {"pair static friction", 32, 0, 0.03, rel_pair_static, 1},
#define REL_ROWS_SHAPES \
    {"outline mass", 33, 0, 0.1, rel_cluster_union, 1}, {"alike spheres", 0, 0, 0.1, rel_cluster_alike, 1}, \
    {"given mass", 33, 0, 0.1, rel_cluster_given, 1}, {"unions of ellipsoids", 0, 0, 0.08, rel_union_balls, 1}, \
    {"unions of polyhedra", 0, 0, 0.08, rel_union_blocks, 1}, \
    {"concave polygons", 0, 0, 0.1, rel_polygon_concave, 1}, {"scaled bodies", 0, 0, 0.05, rel_scaled_bodies, 1},
#define REL_ROWS_CONTAINERS {"outflow", 19, 1, 0, rel_outflow, REL_ACTS_WALL}, \
    {"flush boxes", 19, 1, 0, rel_boxes, REL_ACTS_WALL},
#define REL_ROWS_WALLS \
    {"rod", 0, 0, 0.05, rel_rod, REL_ACTS_WALL}, {"fractions of segments", 0, 0, 0.1, rel_fractions, REL_ACTS_WALL}, \
    {"bars", 34, 0, 0.25, rel_sieve_bars, REL_ACTS_WALL}, \
    {"square holes", 34, 0, 0.25, rel_sieve_square, REL_ACTS_WALL}, \
    {"round holes", 34, 0, 0.25, rel_sieve_round, REL_ACTS_WALL}, \
    {"slots", 34, 0, 0.25, rel_sieve_slots, REL_ACTS_WALL}, \
    {"reduced holes", 34, 0, 0.25, rel_sieve_reduced, REL_ACTS_WALL}, \
    {"thick plate", 0, 0, 0.4, rel_sieve_thick, REL_ACTS_WALL}, \
    {"two layers", 0, 0, 0.4, rel_sieve_lift, REL_ACTS_WALL}, \
    {"staggered", 0, 0, 0.4, rel_sieve_staggered, REL_ACTS_WALL}, \
    {"sieve disc", 0, 0, 0.4, rel_sieve_disc, REL_ACTS_WALL}, \
    {"other model", 0, 0, 0.4, rel_sieve_model, REL_ACTS_WALL}, \
    {"clearance", 0, 0, 0.4, rel_sieve_clearance, REL_ACTS_WALL},
#define REL_ROWS_LATER \
    {"bonds made", 0, 0, 0.8, rel_bonds, 1}, {"user motion with data", 0, 0, 0.3, rel_user_motion, REL_ACTS_WALL}, \
    {"table", 0, 0, 0.05, rel_table, REL_ACTS_WALL}, {"table repeats", 0, 0, 0.3, rel_table_again, REL_ACTS_WALL}, \
    {"phase", 0, 0, 0.2, rel_phase, REL_ACTS_WALL}, {"servo stress", 35, 0, 0.2, rel_servo_stress, 0}, \
    {"servo travel", 0, 0, 0.2, rel_servo_travel, 0}, {"servo ramp", 0, 0, 0.2, rel_servo_ramp, 0}, \
    {"servo near", 0, 0, 0.5, rel_servo_low, 0}, {"servo table", 35, 0, 0.2, rel_servo_table, 0}, \
    {"members", 0, 0, 0.8, rel_members, 0}, {"push", 0, 0, 0.05, rel_push, 0}, \
    {"push of a material", 0, 0, 0.2, rel_push_material, 0}, {"push of a group", 0, 0, 0.3, rel_push_group, 0}, \
    {"push in a cylinder", 0, 0, 0.2, rel_push_cylinder, 0}, {"push of a shape", 0, 0, 0.2, rel_push_shape, 0}, \
    {"push of radii", 0, 0, 0.2, rel_push_radii, 0}, {"push inside", 0, 0, 0.2, rel_push_inside, 0}, \
    {"torque", 0, 0, 0.05, rel_motor_torque, 0}, {"joint to a wall", 0, 0, 0.2, rel_joint_wall, 0}, \
    {"joint with contacts", 0, 0, 0.2, rel_joint_collide, 0}, {"rail of one axis", 36, 0, 0.2, rel_rail_one, 0}, \
    {"rail of spins", 36, 0, 0.2, rel_rail_spin, 0}, {"rail of a wall", 0, 0, 0.3, rel_rail_wall, 0}, \
    {"feed of classes", 37, 0, 0.2, rel_feed_classes, REL_ACTS_FED}, \
    {"endless feed", 0, 0, 0.2, rel_feed_endless, REL_ACTS_FED}, \
    {"feed at once", 0, 0, 0.1, rel_feed_at_once, REL_ACTS_FED}, \
    {"feed by mass", 0, 0, 0.2, rel_feed_mass, REL_ACTS_FED}, \
    {"round feed", 0, 0, 0.2, rel_feed_round, REL_ACTS_FED}, {"feed seed", 0, 0, 0.2, rel_feed_seed, REL_ACTS_FED}, \
    {"thrown feed", 0, 0, 0.2, rel_feed_thrown, REL_ACTS_FED}, \
    {"feed in a window", 0, 0, 0.2, rel_feed_window, REL_ACTS_FED}, \
    {"feed inside", 0, 0, 0.2, rel_feed_inside, REL_ACTS_FED}, \
    {"feed of shapes", 0, 0, 0.2, rel_feed_shapes, REL_ACTS_FED}, \
    {"feed of a material", 0, 0, 0.2, rel_feed_materials, REL_ACTS_FED}, \
    {"feed of sizes", 37, 0, 0.2, rel_feed_sizes, REL_ACTS_FED}, {"outlet beyond", 0, 0, 0.2, rel_outlet_beyond, 0}, \
    {"outlet of a material", 0, 0, 0.2, rel_outlet_material, 0}, {"residence times", 0, 0, 0.2, rel_outlet_times, 0}, \
    {"outlet of a wall", 0, 0, 0.2, rel_outlet_frame, 0}, {"outlet wanted", 0, 0, 0.2, rel_outlet_wanted, 0}, \
    {"outlet classes", 0, 0, 0.2, rel_outlet_classes, 0}, {"average of a group", 0, 0, 0.3, rel_average_group, 0}, \
    {"wide average", 0, 0, 0.2, rel_average_width, 0}, {"variance", 0, 0, 0.2, rel_average_variance, 0}, \
    {"average of bodies", 0, 0, 0.2, rel_average_bodies, 0}, \
    {"average of a material", 0, 0, 0.2, rel_average_material, 0}, \
    {"average in a window", 0, 0, 0.2, rel_average_window, 0}, {"average of radii", 0, 0, 0.2, rel_average_radii, 0}, \
    {"cell shear", 38, 0, 0.45, rel_cell_shear, 0}, {"cell stress", 38, 0, 0.45, rel_cell_stress, 0}, \
    {"cell later", 0, 0, 0.3, rel_cell_later, 0}
#endif
