/* print.h - a scene as a C program of its own: `rel_print` writes everything up to main's last lines, which the relation
   adds. A program makes the scene in a function `scene` that takes what differs between the two runs. */
#ifndef REL_PRINT_H
#define REL_PRINT_H
#include "run.h"

static void rel_number(FILE *out, double x) {
    char text[40];
    int digits;
    for (digits = 3; digits < 18; digits++) {              /* as few as keep the value */
        snprintf(text, sizeof text, "%.*g", digits, x);
        if (!(strtod(text, 0) < x || strtod(text, 0) > x)) break;
    }
    fputs(text, out);
}
static void rel_name(FILE *out, const rel_scene *s, int op) {
    if (op < 0) { fputs("none", out); return; }
    if (s->op[op].call == REL_A_BODY) fprintf(out, "b[%d]", op);
    else fprintf(out, "%s%d", rel_calls[s->op[op].call].makes, op);
}
/* The value of a field as an expression. */
static void rel_value(FILE *out, const rel_scene *s, const rel_op *op, const rel_field *f, const rel_set *v) {
    int k;
    switch (f->type) {
    case REL_INT: case REL_INT3: fprintf(out, "%d", (int)v->v[0]); break;
    case REL_REAL: case REL_DOUBLE: rel_number(out, v->v[0]); break;
    case REL_VEC: case REL_QUAT: case REL_BOX: {
        const int n = f->type == REL_VEC ? 3 : f->type == REL_QUAT ? 4 : 6;
        fputs(n == 3 ? "dem_vec3_make(" : n == 4 ? "dem_quat_make(" : "dem_box_make(", out);
        for (k = 0; k < n; k++) { if (k) fputs(", ", out); rel_number(out, v->v[k]); }
        fputs(")", out);
        break;
    }
    case REL_REF: case REL_BODY: rel_name(out, s, (int)v->v[0]); break;
    case REL_REALS: case REL_INTS:
        fprintf(out, "%s_%d", f->name, (int)(op - s->op));         /* rel_lists declares it */
        break;
    case REL_CODE: fputs(rel_codes[(int)v->v[0]].name, out); break;
    case REL_TEXT: fprintf(out, "\"%s\"", rel_texts[(int)v->v[0]]); break;
    default: break;
    }
}
static const rel_set *rel_given(const rel_op *op, const char *name, size_t length) {
    const rel_call *c = &rel_calls[op->call];
    int i;
    for (i = 0; i < op->count; i++) {
        const char *own = c->fields[op->set[i].field].name;
        if (strlen(own) == length && !strncmp(own, name, length)) return &op->set[i];
    }
    return 0;
}
/* Arrays for the lists of an op. */
static void rel_lists(FILE *out, const rel_scene *s, const rel_op *op) {
    const rel_call *c = &rel_calls[op->call];
    int i, k;
    for (i = 0; i < op->count; i++) {
        const rel_set *v = &op->set[i];
        const rel_field *f = &c->fields[v->field];
        const int refs = f->type == REL_REF_ARRAY && strncmp(f->name, "d.", 2);
        if (f->type != REL_REALS && f->type != REL_INTS && !refs) continue;
        fprintf(out, "    %s %s_%d[] = {", f->type == REL_REALS ? "dem_real" : refs ? "dem_shape" : "int32_t", f->name,
                (int)(op - s->op));
        for (k = 0; k < v->count; k++) {
            if (k) fputs(", ", out);
            if (refs) rel_name(out, s, (int)s->pool[v->at + k]);
            else rel_number(out, s->pool[v->at + k]);
        }
        fputs("};\n", out);
    }
}
static void rel_desc(FILE *out, const rel_scene *s, const rel_op *op, const char *indent) {
    const rel_call *c = &rel_calls[op->call];
    int i, k;
    if (!*c->desc) return;
    fprintf(out, "%s{ %s d%s%s;", indent, c->desc, *c->zero == '{' ? "" : " = ", *c->zero == '{' ? "" : c->zero);
    if (op->call == REL_PAIR) {
        fputs(" dem_pair_get(w, ", out);
        rel_name(out, s, (int)rel_given(op, "a", 1)->v[0]);
        fputs(", ", out);
        rel_name(out, s, (int)rel_given(op, "b", 1)->v[0]);
        fputs(", &d);", out);
    }
    for (i = 0; i < op->count; i++) {
        const rel_set *v = &op->set[i];
        const rel_field *f = &c->fields[v->field];
        if (strncmp(f->name, "d.", 2)) continue;
        if (f->type == REL_INT3)
            for (k = 0; k < 3; k++) fprintf(out, " %s[%d] = %d;", f->name, k, (int)v->v[k]);
        else if (f->type == REL_REAL_ARRAY || f->type == REL_DOUBLE_ARRAY || f->type == REL_REF_ARRAY)
            for (k = 0; k < v->count; k++) {
                fprintf(out, " %s[%d] = ", f->name, k);
                if (f->type == REL_REF_ARRAY) rel_name(out, s, (int)s->pool[v->at + k]);
                else rel_number(out, s->pool[v->at + k]);
                fputs(";", out);
            }
        else {
            fprintf(out, " %s = ", f->name);
            if (f->type == REL_INT && f->at < sizeof(rel_a_world)) fputs("", out);
            rel_value(out, s, op, f, v);
            fputs(";", out);
        }
    }
    fputs(" ", out);
}
/* The text of a call: $name is a value, #name the length of a list. */
static void rel_text(FILE *out, const rel_scene *s, const rel_op *op) {
    const rel_call *c = &rel_calls[op->call];
    const char *p;
    for (p = c->text; *p; p++) {
        size_t n = 0;
        const rel_set *v;
        int i;
        if (*p != '$' && *p != '#') { fputc(*p, out); continue; }
        while ((p[n + 1] >= 'a' && p[n + 1] <= 'z') || p[n + 1] == '_' || p[n + 1] == '.') n++;
        v = rel_given(op, p + 1, n);
        for (i = 0; i < c->field_count; i++)
            if (strlen(c->fields[i].name) == n && !strncmp(c->fields[i].name, p + 1, n)) break;
        if (*p == '#') fprintf(out, "%d", v ? v->count : 0);
        else if (v && c->fields[i].type == REL_REF_ARRAY) fprintf(out, "%s_%d", c->fields[i].name, (int)(op - s->op));
        else if (v) rel_value(out, s, op, &c->fields[i], v);
        else {                                             /* its default */
            rel_set zero;
            memset(&zero, 0, sizeof zero);
            if (c->defaults && c->fields[i].type == REL_INT) zero.v[0] = *(const int *)((const char *)c->defaults + c->fields[i].at);
            if (c->defaults && c->fields[i].type == REL_REAL) zero.v[0] = (double)*(const dem_real *)((const char *)c->defaults + c->fields[i].at);
            rel_value(out, s, op, &c->fields[i], &zero);
        }
        p += n;
    }
}
static void rel_call_print(FILE *out, const rel_scene *s, int at, const char *indent) {
    const rel_op *op = &s->op[at];
    const rel_call *c = &rel_calls[op->call];
    rel_lists(out, s, op);
    if (op->call == REL_A_BODY) {
        static const char *const names[] = {"material", "shape", "radius", "position", "velocity", "spin"};
        const rel_set *q = rel_given(op, "orientation", 11), *scale = rel_given(op, "scale", 5);
        int k;
        fprintf(out, "%sb[%d] = body(w", indent, at);
        for (k = 0; k < 6; k++) {
            const rel_set *v = rel_given(op, names[k], strlen(names[k]));
            fputs(", ", out);
            if (v) rel_value(out, s, op, &c->fields[v->field], v);
            else fputs(k == 1 ? "ball" : k == 2 ? "0" : "still", out);
        }
        fputs(", ", out);
        if (q) rel_value(out, s, op, &c->fields[q->field], q);
        else fputs("level", out);
        fputs(", ", out);
        rel_number(out, scale ? scale->v[0] : 1);
        fputs(");\n", out);
        return;
    }
    if (op->call == REL_PAIR && !rel_given(op, "a", 1)) return;
    rel_desc(out, s, op, indent);
    if (!*c->desc) fputs(indent, out);
    if (*c->makes) {
        rel_name(out, s, at);
        fputs(" = ", out);
    }
    rel_text(out, s, op);
    fputs(*c->desc ? "; }\n" : ";\n", out);
}
static int rel_uses(const rel_scene *s, int call) {
    int i;
    for (i = 0; i < s->count; i++) if (s->op[i].call == call) return 1;
    return 0;
}
/* Writes a program whose function `scene` builds the world and `later` makes the calls of a step. */
static void rel_print(FILE *out, const rel_scene *s, const char *why) {
    int i, k, first;
    fprintf(out, "/* %s */\n#define DEM_IMPLEMENTATION\n#include \"dem.h\"\n", why);
    for (k = 0; k < REL_CODES; k++)
        for (i = 0; i < s->count; i++)
            for (first = 0; first < s->op[i].count; first++)
                if (rel_calls[s->op[i].call].fields[s->op[i].set[first].field].type == REL_CODE &&
                    (int)s->op[i].set[first].v[0] == k) {
                    fprintf(out, "%s\n", rel_codes[k].text);
                    i = s->count - 1;
                    break;
                }
    fprintf(out, "static dem_body b[%d];\n", s->count);
    for (i = 0; i < s->count; i++)
        if (*rel_calls[s->op[i].call].makes && s->op[i].call != REL_A_BODY) {
            fprintf(out, "static %s ", rel_calls[s->op[i].call].type);
            rel_name(out, s, i);
            fputs(";\n", out);
        }
    if (rel_uses(s, REL_A_BODY))
        fputs("static const dem_vec3 still = {0, 0, 0}; static const dem_quat level = {1, 0, 0, 0}; static const dem_shape ball = {0};\n"
              "static dem_body body(dem_world *w, dem_material m, dem_shape s, double r, dem_vec3 x, dem_vec3 v, dem_vec3 spin,\n"
              "                     dem_quat q, double scale) {\n"
              "    dem_real turn[4] = {q.w, q.x, q.y, q.z}, size = scale; dem_body_state state; dem_body id;\n"
              "    if (s.id) { dem_bodies_add(w, m, s, 1, &x.x, turn, &v.x, &spin.x, &size); return dem_body_id_get(w, dem_bodies_get(w).count - 1); }\n"
              "    id = dem_sphere_add(w, m, r, x); dem_body_get(w, id, &state); state.velocity = v; state.spin = spin;\n"
              "    dem_body_set(w, id, &state); return id;\n}\n", out);
    if (rel_uses(s, REL_MESH))
        fputs("static dem_wall mesh(dem_world *w, dem_material m, int n, dem_real *x, int k, int32_t *t) {\n"
              "    dem_mesh mesh; mesh.vertex_count = n; mesh.triangle_count = k; mesh.vertices = x; mesh.triangles = t; return dem_wall_mesh_add(w, m, &mesh);\n}\n", out);
    if (rel_uses(s, REL_PROFILE))
        fputs("static dem_wall profile(dem_world *w, dem_material m, int n, dem_real *x, int k, int32_t *t, int rule) {\n"
              "    dem_profile p; p.vertex_count = n; p.segment_count = k; p.vertices = x; p.segments = t; return dem_wall_profile_add(w, m, &p, rule);\n}\n", out);
    if (rel_uses(s, REL_FIX))
        fputs("static void fix(dem_world *w, dem_body b, int fixed) { dem_selection s = DEM_SELECTION; s.count = 1; s.bodies = &b; dem_bodies_fixed_set(w, &s, fixed); }\n", out);
    if (rel_uses(s, REL_KICK))
        fputs("static void kick(dem_world *w, dem_body b, dem_vec3 v, dem_vec3 spin) { dem_selection s = DEM_SELECTION; s.count = 1; s.bodies = &b; dem_bodies_velocity_set(w, &s, v, spin); }\n", out);
    fputs("static dem_world *scene(int threads, int skip) {\n    dem_world *w;\n", out);
    rel_call_print(out, s, 0, "    ");
    for (i = 1; i < s->count; i++) if (!s->op[i].step) rel_call_print(out, s, i, "    ");
    fputs("    (void)threads; (void)skip;\n    return w;\n}\n", out);
    fputs("static void later(dem_world *w, int step) {\n    (void)w; (void)step;\n", out);
    for (i = 1; i < s->count; i++)
        if (s->op[i].step) {
            fprintf(out, "    if (step == %d) {\n", s->op[i].step);
            rel_call_print(out, s, i, "        ");
            fputs("    }\n", out);
        }
    fputs("}\n", out);
}
#endif
