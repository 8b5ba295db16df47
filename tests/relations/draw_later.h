/* draw_later.h - rows that change what other rows added: a motion that follows another one, a joint whose bodies are
   fixed, a pair that changes, averages that begin late, a bar in a periodic world. draw.h includes it. */
#ifndef REL_DRAW_LATER_H
#define REL_DRAW_LATER_H

static rel_op *rel_latest(const rel_draw *d, int call) {
    int i;
    for (i = d->s->count - 1; i > 0; i--) if (d->s->op[i].call == call) return &d->s->op[i];
    return 0;
}
/* The wall that moves gets another motion, from the pose in which it is then; a wall that rotates leans. */
static int rel_second_motion(rel_draw *d) {
    rel_op *m = d->moved ? rel_latest(d, REL_MOTION) : 0;
    int step, i;
    if (!m) return 0;
    step = m->step + 1 + rel_any(d, d->s->steps);
    if (step >= d->s->steps) return 0;
    for (i = 0; i < m->count && !d->planar; i++)
        if (m->set[i].field == rel_field_of(REL_MOTION, "axis")) m->set[i].v[1] = 0.1;
    m = rel_add(d, REL_MOTION, step);
    rel_put(m, "wall", d->wall[0]);
    if (rel_chance(d->r, 0.5)) {
        rel_put(m, "kind", DEM_MOTION_TRANSLATING);
        rel_put3(m, "velocity", rel_vary(d, -0.05, 0.05), rel_vary(d, -0.05, 0.05), 0);
    } else {
        rel_put(m, "kind", DEM_MOTION_ROTATING);
        rel_put3(m, "axis", 0, 0, 1);
        rel_put(m, "speed", rel_vary(d, -20, 20));
    }
    return 1;
}
/* Both bodies of a joint are fixed later. */
static int rel_joint_fixed(rel_draw *d) {
    static const char *const ends[] = {"a", "b"};
    const rel_op *joint = rel_latest(d, REL_JOINT);
    const int step = rel_when(d);
    int e, i, body[2] = {-1, -1};
    for (e = 0; joint && e < 2; e++)
        for (i = 0; i < joint->count; i++)
            if (joint->set[i].field == rel_field_of(REL_JOINT, ends[e])) body[e] = (int)joint->set[i].v[0];
    for (e = 0; e < 2; e++) {
        for (i = 0; i < d->bodies && d->body[i] != body[e]; i++) continue;
        if (i == d->bodies) body[e] = -1;      /* removed */
    }
    for (e = 0; e < 2 && body[0] >= 0; e++) {
        rel_op *f;
        if (body[e] < 0) continue;
        f = rel_add(d, REL_FIX, step);
        rel_put(f, "body", body[e]);
        rel_put(f, "fixed", 1);
    }
    return body[0] >= 0;
}
static int rel_average_late(rel_draw *d) {
    rel_op *f = rel_latest(d, REL_FIELD);
    if (!f) return 0;
    f->step = rel_when(d);
    rel_put(f, "interval", rel_vary(d, 5e-5, 2e-3));
    if (rel_chance(d->r, 0.5)) rel_put(f, "start", rel_vary(d, 0, 2e-3));
    return 1;
}
/* Coefficients of a pair change while contacts hold their histories. */
static int rel_pair_later(rel_draw *d) {
    rel_op *p = rel_pair_of(d);
    p->step = rel_when(d);
    rel_put(p, "friction", rel_chance(d->r, 0.5) ? 0 : rel_vary(d, 0.1, 0.8));
    rel_put(p, "rolling_friction", rel_chance(d->r, 0.5) ? 0 : rel_vary(d, 0.01, 0.3));
    return 1;
}
static int rel_row(const char *name);
static rel_set *rel_set_of(rel_op *op, const char *name) {
    int k;
    for (k = 0; k < op->count; k++) if (op->set[k].field == rel_field_of(op->call, name)) return &op->set[k];
    return 0;
}
/* A sheet between the first two bodies, which are neighbours along x. */
static int rel_sheet(rel_draw *d) {
    double v[12], t[6] = {0, 1, 2, 0, 2, 3}, *x, *y;
    rel_op *m;
    int i;
    if (d->planar || d->periodic || d->bodies < 2) return 0;
    x = rel_set_of(&d->s->op[d->body[0]], "position")->v;
    y = rel_set_of(&d->s->op[d->body[1]], "position")->v;
    if (y[1] > x[1] || y[2] > x[2]) return 0;
    for (i = 0; i < 4; i++) {
        v[3*i] = (x[0] + y[0])/2;
        v[3*i + 1] = (i + 1)/2%2 ? 2*d->a : -2*d->a;
        v[3*i + 2] = i/2 ? 2*d->h : x[2] - 0.5*d->R;
    }
    m = rel_add(d, REL_MESH, 0);
    rel_put(m, "material", rel_stuff(d));
    rel_list(d, m, "vertices", v, 12);
    rel_list(d, m, "triangles", t, 6);
    return 1;
}
/* A cube of the lowest row lies on the floor and slides; over the seam, if the floor consists of boxes. */
static int rel_laid(rel_draw *d) {
    const double low = rel_set_of(&d->s->op[d->body[0]], "position")->v[2];
    int i, k, e;
    for (i = 0; i < d->bodies; i++) {
        rel_op *b = &d->s->op[d->body[i]];
        const rel_set *shape = rel_set_of(b, "shape");
        double *x = rel_set_of(b, "position")->v;
        if (!shape || d->s->op[(int)shape->v[0]].feature != rel_row("cubes") || x[2] > low) continue;
        x[2] = 0.5*d->R;
        if (d->scaled) rel_put(b, "scale", 1);
        rel_slot(b, "orientation")->v[0] = 1;
        rel_put3(b, "velocity", rel_vary(d, 0.1, 0.6), rel_vary(d, -0.2, 0.2), 0);
        rel_slot(b, "spin");
        for (k = 0; k < 2 && k < d->walls; k++) {
            rel_op *box = &d->s->op[d->wall[k]];
            const double at = rel_vary(d, x[0] + 0.8*d->R, x[0] + 0.8*d->R);
            for (e = 0; e < 24 && box->feature == rel_row("flush boxes"); e += 3) {
                double *seam = d->s->pool + rel_set_of(box, "vertices")->at + e;
                if (fabs(*seam) < 1.4*d->a) *seam = at;
            }
        }
        return 1;
    }
    return 0;
}
/* A round bar between the places of a feed, above all bodies, which does not repeat across the periods. The feed is
   added if there is none. */
static int rel_bar(rel_draw *d) {
    const double h = 0.86*d->h;
    rel_op *c;
    int i, k;
    if (d->planar || d->periodic != 3) return 0;
    for (i = 0; i < d->bodies; i++)
        for (k = 0; k < d->s->op[d->body[i]].count; k++) {
            const rel_set *v = &d->s->op[d->body[i]].set[k];
            if (v->field == rel_field_of(REL_A_BODY, "position") && v->v[2] > h - 2*d->R) return 0;
        }
    if (!rel_latest(d, REL_FEED)) d->s->has[rel_row("feed")] = (unsigned char)rel_feed(d);
    c = rel_add(d, REL_CYLINDER, 0);
    rel_put(c, "material", rel_stuff(d));
    rel_put3(c, "point", 0, 0, h);
    rel_put3(c, "axis", 1, 0, 0);
    rel_put(c, "radius", 0.5*d->R);
    rel_put(c, "inside", 0);
    return 1;
}
#endif
