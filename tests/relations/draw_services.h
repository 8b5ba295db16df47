/* draw_services.h - rows of features that write, read and measure. They are the last rows of draw.h, because they refer
   to walls, outlets and fields that others have added, and have a chance each. */
#ifndef REL_DRAW_SERVICES_H
#define REL_DRAW_SERVICES_H

/* An op of this kind, by chance; -1: the scene has none. */
static int rel_one_of(rel_draw *d, int call) {
    int at[REL_OPS], n = 0, i;
    for (i = 0; i < d->s->count; i++) if (d->s->op[i].call == call) at[n++] = i;
    return n ? at[rel_any(d, n)] : -1;
}
static double rel_often(rel_draw *d) { return d->impulses ? rel_vary(d, 2e-3, 1e-2) : rel_vary(d, 2e-4, 2e-3); }
static rel_op *rel_output_of(rel_draw *d, int kind, const char *path) {
    rel_op *o = rel_add(d, REL_OUTPUT, rel_chance(d->r, 0.2) ? rel_when(d) : 0);
    if (kind) rel_put(o, "kind", kind);
    rel_put(o, "path", rel_text_of(path));
    rel_put(o, "interval", rel_often(d));
    if (rel_chance(d->r, 0.2)) rel_put(o, "start", rel_vary(d, 0, 1e-3));
    return o;
}
#define REL_PLAIN_OUTPUT(function, kind, path) \
    static int function(rel_draw *d) { rel_output_of(d, kind, path); return 1; }
REL_PLAIN_OUTPUT(rel_out_grains, DEM_OUTPUT_VTP, "grains_####.vtp")
REL_PLAIN_OUTPUT(rel_out_xyz, DEM_OUTPUT_XYZ, "grains.xyz")
REL_PLAIN_OUTPUT(rel_out_contacts, DEM_OUTPUT_CONTACTS, "contacts_####.vtp")
REL_PLAIN_OUTPUT(rel_out_surfaces, DEM_OUTPUT_SURFACES, "surfaces_####.vtp")
REL_PLAIN_OUTPUT(rel_out_walls, DEM_OUTPUT_WALLS, "walls_####.vtp")
REL_PLAIN_OUTPUT(rel_out_state, DEM_OUTPUT_CHECKPOINT, "state_####.dem")
REL_PLAIN_OUTPUT(rel_out_bodies, DEM_OUTPUT_BODIES_CSV, "bodies_####.csv")
REL_PLAIN_OUTPUT(rel_out_pairs, DEM_OUTPUT_CONTACTS_CSV, "contacts_####.csv")
REL_PLAIN_OUTPUT(rel_out_steps, DEM_OUTPUT_CSV, "steps.csv")
/* An output of something that another row has added. */
static int rel_output_with(rel_draw *d, int kind, const char *path, const char *field, int call) {
    const int of = rel_one_of(d, call);
    if (of >= 0) rel_put(rel_output_of(d, kind, path), field, of);
    return of >= 0;
}
static int rel_out_loads(rel_draw *d) {
    return d->walls ? rel_put(rel_output_of(d, DEM_OUTPUT_CSV, "loads.csv"), "wall", d->wall[0]), 1 : 0;
}
static int rel_out_counts(rel_draw *d) { return rel_output_with(d, DEM_OUTPUT_CSV, "counts.csv", "outlet",
    REL_OUTLET); }
static int rel_out_field(rel_draw *d) { return rel_output_with(d, DEM_OUTPUT_FIELD_CSV, "field_####.csv", "field",
    REL_FIELD); }
static int rel_out_mixing(rel_draw *d) {
    rel_op *o = rel_output_of(d, DEM_OUTPUT_CSV, "mixing.csv");
    rel_put_box(o, "mixing.box", -d->a, -d->a, -d->h, d->a, d->planar ? d->h : d->a, d->h);
    rel_put3(o, "mixing.cells", 2, 2, 2);
    if (d->materials > 1) rel_put(o, "mixing.material", d->material[1]);
    else rel_put(o, "mixing.radius_max", 0.8*d->R);
    return 1;
}
static int rel_out_values(rel_draw *d) {
    rel_op *o = rel_output_of(d, DEM_OUTPUT_CSV, "values.csv");
    rel_put(o, "columns", rel_text_of("one two"));
    rel_put(o, "values", rel_code_of("two_values"));
    return 1;
}
static int rel_out_call(rel_draw *d) {
    rel_op *o = rel_add(d, REL_OUTPUT, 0);
    rel_put(o, "interval", rel_often(d));
    rel_put(o, "function", rel_code_of("beat"));
    return 1;
}
static int rel_out_every(rel_draw *d) {
    rel_op *o = rel_add(d, REL_EVERY, 0);
    rel_put(o, "kind", DEM_OUTPUT_VTP);
    rel_put(o, "path", rel_text_of("every_####.vtp"));
    rel_put(o, "interval", rel_often(d));
    return 1;
}
static int rel_out_end(rel_draw *d) {
    const int o = rel_one_of(d, REL_OUTPUT);
    if (o < 0 || d->s->op[o].step) return 0;
    rel_put(rel_add(d, REL_OUTPUT_END, rel_when(d)), "output", o);
    return 1;
}
static int rel_replayed(rel_draw *d) {
    rel_op *r = rel_add(d, REL_REPLAY, rel_chance(d->r, 0.3) ? rel_when(d) : 0), *f;
    const int at = rel_index(d, r);
    rel_put(r, "path", rel_text_of("replay.html"));
    rel_put(r, "interval", rel_often(d));
    if (rel_chance(d->r, 0.5)) rel_put(r, "number_fn", rel_code_of("shade"));
    if (rel_chance(d->r, 0.5)) rel_put(r, "contacts", 1 + rel_any(d, 3));
    if (rel_chance(d->r, 0.5)) {
        f = rel_add(d, REL_FRAME, d->s->op[at].step + 1);
        rel_put(f, "replay", at);
        rel_put(f, "value", rel_vary(d, -1, 1));
    }
    return 1;
}
static int rel_heard(rel_draw *d) {
    const int on = rel_field_of(REL_WORLD, "ledger");
    rel_op *e;
    int i;
    for (i = 0; i < d->s->op[0].count && d->s->op[0].set[i].field != on; i++) continue;
    if (i == d->s->op[0].count) return 0;
    e = rel_add(d, REL_EVENTS, rel_chance(d->r, 0.3) ? rel_when(d) : 0);
    rel_put(e, "function", rel_code_of("hear"));
    if (rel_chance(d->r, 0.5)) rel_put(e, "begins", 1);
    return 1;
}
static int rel_not_heard(rel_draw *d) {
    const int e = rel_one_of(d, REL_EVENTS);
    if (e < 0 || d->s->op[e].step) return 0;
    rel_add(d, REL_EVENTS_STOP, rel_when(d));
    return 1;
}
static int rel_grouped(rel_draw *d) {
    int k;
    rel_put(rel_the_world(d), "groups", rel_text_of("coarse fine"));
    for (k = 0; k < 4; k++) {
        rel_op *g = rel_add(d, REL_MEMBER, rel_chance(d->r, 0.3) ? rel_when(d) : 0);
        rel_put(g, "body", d->body[rel_any(d, d->bodies)]);
        rel_put(g, "member", rel_chance(d->r, 0.8));
    }
    return 1;
}
static int rel_body_means(rel_draw *d) {
    rel_op *f;
    if (!rel_average(d)) return 0;
    f = &d->s->op[d->s->count - 1];
    rel_put(f, "bodies", 1);
    if (rel_one_of(d, REL_MEMBER) >= 0 && rel_chance(d->r, 0.5)) rel_put(f, "group.id", 1);
    return 1;
}
static int rel_variances(rel_draw *d) {
    if (!rel_average(d)) return 0;
    rel_put(&d->s->op[d->s->count - 1], "variance", 1);
    return 1;
}
/* Sums that begin again. */
static int rel_resets(rel_draw *d) {
    const int field = rel_one_of(d, REL_FIELD), outlet = rel_one_of(d, REL_OUTLET);
    if (d->walls) rel_put(rel_add(d, REL_LOADS_RESET, rel_when(d)), "wall", d->wall[0]);
    if (field >= 0) rel_put(rel_add(d, REL_FIELD_RESET, rel_when(d)), "field", field);
    if (outlet >= 0) rel_put(rel_add(d, REL_OUTLET_RESET, rel_when(d)), "outlet", outlet);
    rel_put(rel_add(d, REL_OVERLAP_RESET, rel_when(d)), "member", 1);
    return 1;
}
/* Numbers of a body and of a wall, which have two. */
static int rel_numbers_set(rel_draw *d) {
    const int on = rel_field_of(REL_WORLD, "body_reals");
    const double two[2] = {rel_vary(d, 0, 5), rel_vary(d, -5, 5)};
    rel_op *n;
    int i;
    for (i = 0; i < d->s->op[0].count && d->s->op[0].set[i].field != on; i++) continue;
    if (i == d->s->op[0].count) return 0;
    n = rel_add(d, REL_REALS_SET, rel_when(d));
    rel_put(n, "body", d->body[rel_any(d, d->bodies)]);
    rel_list(d, n, "reals", two, 2);
    if (!d->walls) return 1;
    n = rel_add(d, REL_WALL_REALS, rel_when(d));
    rel_put(n, "wall", d->wall[0]);
    rel_list(d, n, "reals", two, 2);
    return 1;
}
/* ---- what changes the scene and has no row elsewhere ---- */
static void rel_upper(rel_draw *d, rel_op *o) {
    if (d->planar) rel_put_box(o, "box", -0.6*d->a, 0.5*d->h, -1.1*d->R, 0.6*d->a, 0.95*d->h, 1.1*d->R);
    else rel_put_box(o, "box", -0.6*d->a, -0.6*d->a, 0.5*d->h, 0.6*d->a, 0.6*d->a, 0.95*d->h);
}
static int rel_filled(rel_draw *d) {
    rel_op *o = rel_add(d, REL_FILL, rel_chance(d->r, 0.5) ? rel_when(d) : 0);
    rel_put(o, "material", rel_stuff(d));
    rel_put(o, "way", rel_any(d, 3));
    rel_put(o, "radius", 0.5*d->R);
    rel_put(o, "count", 3 + rel_any(d, 5));
    rel_upper(d, o);
    return 1;
}
static int rel_filled_shapes(rel_draw *d) {
    const int which = rel_any(d, d->shapes);
    rel_op *o;
    if (d->shape[which] < 0) return 0;
    o = rel_add(d, REL_FILL_SHAPE, rel_chance(d->r, 0.5) ? rel_when(d) : 0);
    rel_put(o, "material", rel_stuff(d));
    rel_put(o, "shape", d->shape[which]);
    rel_put(o, "count", 2);
    rel_upper(d, o);
    return 1;
}
/* Two spheres above all others. */
static int rel_spheres_at_once(rel_draw *d) {
    const double up = d->h - 0.6*d->R, x[6] = {-d->R, d->planar ? up : 0, d->planar ? 0 : up, d->R, d->planar ? up :
        0, d->planar ? 0 : up};
    rel_op *o = rel_add(d, REL_SPHERES, 0);
    rel_put(o, "material", rel_stuff(d));
    rel_list(d, o, "positions", x, 6);
    rel_put(o, "radius", 0.4*d->R);
    return 1;
}
static int rel_heated(rel_draw *d) {
    if (d->bodies < 2) return 0;
    rel_put(rel_add(d, REL_TEMPERATURE, rel_when(d)), "temperature", rel_vary(d, 1e-4, 1e-2));
    return 1;
}
static int rel_removed_some(rel_draw *d) {
    if (d->bodies < 2) return 0;
    rel_put(rel_add(d, REL_REMOVE_SOME, rel_when(d)), "body", d->body[--d->bodies]);
    return 1;
}
static int rel_rubbed(rel_draw *d) {
    rel_op *o = rel_add(d, REL_RUB, rel_when(d));
    rel_put(o, "material", rel_stuff(d));
    rel_put(o, "friction", rel_vary(d, 0.1, 0.8));
    return 1;
}
static int rel_motor_later(rel_draw *d) {
    const int j = rel_one_of(d, REL_JOINT);
    const rel_set *kind = j < 0 ? 0 : &d->s->op[j].set[0];
    rel_op *o;
    if (j < 0 || kind->field != rel_field_of(REL_JOINT, "kind") || (int)kind->v[0] != DEM_JOINT_REVOLUTE) return 0;
    o = rel_add(d, REL_MOTOR_SET, rel_when(d));
    rel_put(o, "joint", j);
    rel_put(o, "motor", DEM_MOTOR_SPEED);
    rel_put(o, "speed", rel_vary(d, -10, 10));
    rel_put(o, "torque", 1e-6);
    return 1;
}
static int rel_joint_gone(rel_draw *d) {
    const int j = rel_one_of(d, REL_JOINT);
    if (j < 0 || rel_one_of(d, REL_MOTOR_SET) >= 0) return 0;
    rel_put(rel_add(d, REL_JOINT_REMOVE, rel_when(d)), "joint", j);
    return 1;
}
static int rel_law_of_stages(rel_draw *d) {
    static const char *const laws[] = {"law_hysteretic", "law_mindlin", "law_rescaled", "law_stepped"};
    if (d->impulses) return 0;
    rel_put(rel_the_world(d), "law", rel_code_of(laws[rel_any(d, 4)]));
    rel_put(rel_the_world(d), "law_memory", 9);
    rel_put(rel_the_world(d), "law_vectors", 2);
    return 1;
}
static int rel_reader_at(int k) {
    int i;
    for (i = 0; i < REL_CODES; i++) if (!strncmp(rel_codes[i].name, "read_", 5) && !k--) return i;
    return -1;
}
static int rel_reading(rel_draw *d) {
    int n = 1 + rel_any(d, 5), readers = 0;
    while (rel_reader_at(readers) >= 0) readers++;
    while (n-- > 0)
        rel_put(rel_add(d, REL_READ, rel_chance(d->r, 0.2) ? 0 : rel_when(d)), "what", rel_reader_at(rel_any(d,
            readers)));
    return 1;
}
#define REL_SERVICE_FEATURES \
    {"groups set", 0, 0, 0.1, rel_grouped, REL_ACTS_TOOK}, {"body averages", 0, 0, 0.1, rel_body_means, 0}, \
    {"variances", 0, 0, 0.08, rel_variances, 0}, {"numbers set", 0, 0, 0.4, rel_numbers_set, REL_ACTS_TOOK}, \
    {"events", 0, 0, 0.3, rel_heard, REL_ACTS_TOOK}, {"events stopped", 0, 0, 0.2, rel_not_heard, REL_ACTS_TOOK}, \
    {"grains VTP", 0, 0, 0.06, rel_out_grains, REL_ACTS_TOOK}, {"grains XYZ", 0, 0, 0.06, rel_out_xyz, REL_ACTS_TOOK}, \
    {"contacts VTP", 0, 0, 0.06, rel_out_contacts, REL_ACTS_TOOK}, {"surfaces VTP", 0, 0, 0.06, rel_out_surfaces, \
        REL_ACTS_TOOK}, \
    {"walls VTP", 0, 0, 0.06, rel_out_walls, REL_ACTS_TOOK}, {"checkpoints", 0, 0, 0.06, rel_out_state, \
        REL_ACTS_TOOK}, \
    {"bodies CSV", 0, 0, 0.06, rel_out_bodies, REL_ACTS_TOOK}, {"contacts CSV", 0, 0, 0.06, rel_out_pairs, \
        REL_ACTS_TOOK}, \
    {"CSV of steps", 0, 0, 0.06, rel_out_steps, REL_ACTS_TOOK}, {"CSV of loads", 0, 0, 0.06, rel_out_loads, \
        REL_ACTS_TOOK}, \
    {"CSV of an outlet", 0, 0, 0.3, rel_out_counts, REL_ACTS_TOOK}, {"CSV of a field", 0, 0, 0.3, rel_out_field, \
        REL_ACTS_TOOK}, \
    {"CSV of mixing", 0, 0, 0.06, rel_out_mixing, REL_ACTS_TOOK}, {"CSV of values", 0, 0, 0.06, rel_out_values, \
        REL_ACTS_TOOK}, \
    {"output calls", 0, 0, 0.08, rel_out_call, REL_ACTS_TOOK}, {"every", 0, 0, 0.06, rel_out_every, REL_ACTS_TOOK}, \
    {"output ended", 0, 0, 0.2, rel_out_end, REL_ACTS_TOOK}, {"replay", 0, 0, 0.08, rel_replayed, REL_ACTS_TOOK}, \
    {"law of stages", 2, 0, 0.12, rel_law_of_stages, REL_ACTS_CONTACT}, {"fill", 0, 0, 0.08, rel_filled, \
        REL_ACTS_FED}, \
    {"fill of shapes", 0, 0, 0.15, rel_filled_shapes, REL_ACTS_FED}, {"spheres at once", 0, 0, 0.08, \
        rel_spheres_at_once, REL_ACTS_TOOK}, \
    {"temperature", 0, 0, 0.08, rel_heated, REL_ACTS_TOOK}, {"selection removed", 0, 0, 0.08, rel_removed_some, \
        REL_ACTS_GONE}, \
    {"material later", 0, 0, 0.1, rel_rubbed, REL_ACTS_TOOK}, {"motor later", 0, 0, 0.4, rel_motor_later, \
        REL_ACTS_TOOK}, \
    {"joint removed", 0, 0, 0.2, rel_joint_gone, REL_ACTS_TOOK}, \
    {"resets", 0, 0, 0.1, rel_resets, REL_ACTS_TOOK}, {"reading", 0, 0, 0.3, rel_reading, REL_ACTS_TOOK}
#endif
