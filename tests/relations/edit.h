/* edit.h - what can be left out of a scene or rounded: calls, fields, vertices and digits. shrink.h decides. */
#ifndef REL_EDIT_H
#define REL_EDIT_H
#include "relate.h"

/* Is there a function that reads these data? law_user belongs to law and law_rate, body_reals_user to body_reals_fn. */
static int rel_is_read(const rel_op *op, const char *user) {
    const size_t n = strlen(user) - (strstr(user, "_user") ? 5 : 4);
    int j;
    for (j = 0; j < op->count; j++) {
        const rel_field *f = &rel_calls[op->call].fields[op->set[j].field];
        if (f->type == REL_CODE && !strncmp(f->name, user, n)) return 1;
    }
    return 0;
}
/* Lists, references, the time step, the tolerance that rel_compare knows, the thickness of discs (0 means 1 m in all
   units), what functions read and what relations expect of each body stay. */
static int rel_needed(const rel_op *op, const rel_field *f) {
    if (f->type >= REL_REF && f->type <= REL_DOUBLE_ARRAY) return 1;
    if (f->type == REL_PATH || op->call == REL_READ) return 1;
    if (f->type == REL_DATA) return rel_is_read(op, f->name);
    if (op->call == REL_WORLD)
        return !strcmp(f->name, "d.dt") || !strcmp(f->name, "d.tolerance") ||
            (rel_given_in(op, "planar") && !strcmp(f->name, "d.thickness")) ||
            (rel_given_in(op, "law") && (!strncmp(f->name, "d.law_", 6) || !strcmp(f->name, "d.body_reals"))) ||
            (rel_given_in(op, "body_reals_fn") && !strcmp(f->name, "d.body_reals"));
    return op->call == REL_A_BODY && (!strcmp(f->name, "position") || !strcmp(f->name, "velocity"));
}
static const rel_field *rel_field_at(const rel_op *op, int j) { return &rel_calls[op->call].fields[op->set[j].field]; }
/* Relations rely on stiffness only if all materials have it. */
static void rel_settle(rel_scene *s) {
    int i, row, all = 1;
    for (i = 0; i < s->count; i++)
        if (s->op[i].call == REL_MATERIAL) {
            const rel_set *v = rel_find(&s->op[i], "stiffness");
            if (!v || !(v->v[0] > 0)) all = 0;
        }
    for (row = 0; row < REL_ROWS; row++) if (!all && !strcmp(rel_features[row].name, "stiffness")) s->has[row] = 0;
}
/* Removes ops `from` to `to` - 1 and all that refer to them. */
static void rel_drop_ops(rel_scene *s, int from, int to) {
    int new_at[REL_OPS], i, j, k, n = 0;
    for (i = 0; i < s->count; i++) {
        rel_op *op = &s->op[i];
        int gone = i >= from && i < to;
        for (j = 0; j < op->count && !gone; j++) {
            const rel_type type = rel_field_at(op, j)->type;
            rel_set *v = &op->set[j];
            if ((type == REL_REF || type == REL_BODY) && v->v[0] >= 0) gone = new_at[(int)v->v[0]] < 0;
            for (k = 0; type == REL_REF_ARRAY && k < v->count; k++)        /* -1: a sphere */
                gone |= s->pool[v->at + k] >= 0 && new_at[(int)s->pool[v->at + k]] < 0;
        }
        new_at[i] = gone ? -1 : n;
        if (gone) continue;
        for (j = 0; j < op->count; j++) {
            const rel_type type = rel_field_at(op, j)->type;
            rel_set *v = &op->set[j];
            if ((type == REL_REF || type == REL_BODY) && v->v[0] >= 0) v->v[0] = new_at[(int)v->v[0]];
            for (k = 0; type == REL_REF_ARRAY && k < v->count; k++)
                if (s->pool[v->at + k] >= 0) s->pool[v->at + k] = new_at[(int)s->pool[v->at + k]];
        }
        if (n != i) s->op[n] = *op;
        n++;
    }
    s->count = n;
}
/* Does a list that ends with -1 contain a call? */
static int rel_among(const int *calls, int call) {
    for (; *calls >= 0; calls++) if (*calls == call) return 1;
    return 0;
}
/* Leaves out calls, and all that refers to what they made: those of the list, or all others if `others`. */
static void rel_leave_calls(rel_scene *s, const int *calls, int others) {
    int i;
    for (i = s->count - 1; i > 0; i--) {
        if (i >= s->count || rel_among(calls, s->op[i].call) == others) continue;
        s->has[s->op[i].feature] = 0;
        rel_drop_ops(s, i, i + 1);
    }
}
static void rel_drop_set(rel_op *op, int j) {
    op->count--;
    memmove(op->set + j, op->set + j + 1, (size_t)(op->count - j)*sizeof *op->set);
}
/* Sets fields of all ops of a call back to their defaults. The list ends with 0. */
static void rel_leave_fields(rel_scene *s, int call, const char *const *names) {
    int i, j;
    for (; *names; names++)
        for (i = 0; i < s->count; i++)
            for (j = s->op[i].count - 1; s->op[i].call == call && j >= 0; j--)
                if (s->op[i].set[j].field == rel_field_of(call, *names)) rel_drop_set(&s->op[i], j);
}
/* Coefficients are in N/m^(3/2) with Hertz's law and in N/m with the others, whatever the law (dem_contact.kn), and
   without law_stiffness the time step is advised for the law of the scene: it becomes one with the units of the
   user-defined law. */
static void rel_fit_units(rel_scene *s) {
    static const char *const linear[] = {"law_plain", "law_stepped", "law_hysteretic", 0};
    static const char *const hertz[] = {"law_spring", "law_mindlin", "law_rescaled", 0};
    const rel_set *law = rel_given_in(&s->op[0], "law");
    const int code = law ? (int)law->v[0] : -1;
    int k;
    for (k = 0; linear[k] && law; k++)
        if (code == rel_code_of(linear[k])) rel_put(&s->op[0], "normal_law", DEM_NORMAL_LINEAR);
    for (k = 0; hertz[k] && law; k++)
        if (code == rel_code_of(hertz[k])) rel_put(&s->op[0], "normal_law", DEM_NORMAL_HERTZ);
}
/* Adds a call at the end of a scene. */
static rel_op *rel_more(rel_scene *s, int call, int step) {
    rel_op *op = &s->op[s->count++];
    if (s->count > REL_OPS) exit(3);
    memset(op, 0, sizeof *op);
    op->call = call;
    op->step = step;
    return op;
}
/* Boxes stay closed, because dem.h promises nothing about meshes that are folded or open below a floor. */
static int rel_is_closed(const rel_op *op) { return op->call == REL_MESH && op->feature == rel_row("flush boxes"); }
/* How many numbers of a list belong together and can be left out; 0: the list stays. */
static int rel_group(const rel_op *op, const char *name) {
    if (rel_is_closed(op)) return 0;
    if (!strcmp(name, "triangles")) return op->call == REL_MESH ? 3 : 2;
    if (!strcmp(name, "points") || (op->call == REL_GRAINS && !strcmp(name, "vertices"))) return 3;
    return strcmp(name, "corners") ? 0 : 2;
}
/* Leaves out the vertices that no triangle or segment has. */
static void rel_drop_vertices(rel_scene *s, rel_op *op) {
    rel_set *x = rel_find(op, "vertices"), *t = rel_find(op, "triangles");
    const int per = op->call == REL_MESH ? 3 : 2;
    int i, k, n = 0;
    for (i = 0; i < x->count/per; i++) {
        int used = 0;
        for (k = 0; k < t->count; k++)
            if ((int)s->pool[t->at + k] == i) { s->pool[t->at + k] = n; used = 1; }
        for (k = 0; k < per && used; k++) s->pool[x->at + per*n + k] = s->pool[x->at + per*i + k];
        n += used;
    }
    x->count = per*n;
}
/* A number with fewer digits; time steps are rounded down. */
static double rel_rounder(double x, int digits, int down) {
    char text[40];
    double y, unit;
    if (!digits) return 0;
    snprintf(text, sizeof text, "%.*e", digits - 1, x);
    y = strtod(text, 0);
    unit = pow(10, floor(log10(fabs(x))) - digits + 1);
    if (down && y > x) { snprintf(text, sizeof text, "%.*e", digits - 1, y - unit); y = strtod(text, 0); }
    return y;
}
/* The numbers of a set, of which there are *count; 0: none that may be rounded. */
static double *rel_numbers_of(rel_scene *s, const rel_op *op, rel_set *v, int *count) {
    const rel_type type = rel_calls[op->call].fields[v->field].type;
    const int list = type == REL_REALS || type == REL_REAL_ARRAY || type == REL_DOUBLE_ARRAY;
    *count = list ? (rel_is_closed(op) ? 0 : v->count) : type == REL_REAL || type == REL_DOUBLE ? 1 :
             type == REL_VEC ? 3 : type == REL_QUAT ? 4 : type == REL_BOX ? 6 : 0;
    return list ? s->pool + v->at : v->v;
}
#endif
