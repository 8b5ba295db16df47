/* print.h - the calls of a scene as C text. program.h makes a program of them.

   The text of a call is written to a page: page 0 for a scene, page 1 for its image, and page 2 for both of them, where
   a number that differs is I(number in the scene, number in the image). */
#ifndef REL_PRINT_H
#define REL_PRINT_H
#include "run.h"
#include <ctype.h>

static char rel_paper[3][1 << 17];
static int rel_side;                           /* the page that is written */
static size_t rel_written;
static void rel_say(const char *format, ...) {
    const size_t room = sizeof *rel_paper - rel_written;
    va_list list;
    int n;
    va_start(list, format);
    n = vsnprintf(rel_paper[rel_side] + rel_written, room, format, list);
    va_end(list);
    if (n < 0 || (size_t)n >= room) { fprintf(stderr, "relations: a call is too long to print\n"); exit(3); }
    rel_written += (size_t)n;
}
static void rel_new_page(int side) {
    rel_side = side;
    rel_written = 0;
    rel_paper[side][0] = 0;
}
/* The length of the number at p; 0: there is none. */
static size_t rel_digits(const char *start, const char *p) {
    char *end;
    const int letter = p > start && (isalnum((unsigned char)p[-1]) || p[-1] == '_' || p[-1] == '.');
    if (letter || !(isdigit((unsigned char)*p) || (*p == '-' && isdigit((unsigned char)p[1])))) return 0;
    strtod(p, &end);
    return (size_t)(end - p);
}
/* Writes pages 0 and 1 as one text to page 2. Returns 0 if they differ in more than numbers. */
static int rel_merge(void) {
    const char *a = rel_paper[0], *b = rel_paper[1];
    rel_new_page(2);
    while (*a || *b) {
        const size_t n = rel_digits(rel_paper[0], a), m = rel_digits(rel_paper[1], b);
        if (n && m && (n != m || strncmp(a, b, n))) rel_say("I(%.*s, %.*s)", (int)n, a, (int)m, b);
        else if (n && m) rel_say("%.*s", (int)n, a);
        else if (*a != *b) return 0;
        else rel_say("%c", *a);
        a += n && m ? n : 1;
        b += n && m ? m : 1;
    }
    return 1;
}
/* A number with as few digits as keep its value, without leading zeros of the exponent. */
static const char *rel_number(double x) {
    static char text[40];
    char *e;
    int digits;
    for (digits = 1; digits < 18; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, x);
        if (!(strtod(text, 0) < x || strtod(text, 0) > x)) break;
    }
    e = strchr(text, 'e');
    if (e && fabs(x) >= 1 && fabs(x) < 1e6 && x == floor(x)) snprintf(text, sizeof text, "%.0f", x);
    else if (e) {
        e += e[1] == '-' ? 2 : 1;
        while ((*e == '0' || *e == '+') && e[1]) memmove(e, e + 1, strlen(e));
    }
    return text;
}
/* The name of what an op makes: bodies have numbers of their own. */
static void rel_name(const rel_scene *s, int op) {
    int i, n = 0;
    for (i = 0; i < op; i++) n += s->op[i].call == REL_A_BODY;
    if (op < 0 || !*rel_calls[s->op[op].call].makes) rel_say("none");
    else if (s->op[op].call == REL_A_BODY) rel_say("b[%d]", n);
    else rel_say("%s%d", rel_calls[s->op[op].call].makes, op);
}
/* The value of a field as an expression. */
static void rel_value(const rel_scene *s, const rel_field *f, const rel_set *v) {
    const int list = f->type == REL_REALS || f->type == REL_INTS || f->type == REL_REF_ARRAY;
    const int n = f->type == REL_VEC ? 3 : f->type == REL_QUAT ? 4 : f->type == REL_BOX ? 6 : list ? v->count : 1;
    int k;
    switch (f->type) {
    case REL_INT: rel_say("%d", (int)v->v[0]); break;
    case REL_REF: case REL_BODY: rel_name(s, (int)v->v[0]); break;
    case REL_CODE: rel_say("%s", rel_codes[(int)v->v[0]].name); break;
    case REL_TEXT: case REL_PATH: rel_say("\"%s\"", rel_texts[(int)v->v[0]]); break;
    case REL_DATA: rel_say("&%s", rel_data[(int)v->v[0]].name); break;
    case REL_WHOLE: rel_say("%llu", (unsigned long long)v->v[0]); break;
    case REL_REAL: case REL_DOUBLE: rel_say("%s", rel_number(v->v[0])); break;
    default:
        rel_say(f->type == REL_VEC ? "V(" :
            f->type == REL_QUAT ? "dem_quat_make(" : f->type == REL_BOX ? "dem_box_make(" :
                f->type == REL_REALS ? "(dem_real[]){" : f->type == REL_INTS ? "(int32_t[]){" : "(dem_shape[]){");
        for (k = 0; k < n; k++) {
            if (k) rel_say(", ");
            if (f->type == REL_REF_ARRAY) rel_name(s, (int)s->pool[v->at + k]);
            else rel_say("%s", rel_number(list ? s->pool[v->at + k] : v->v[k]));
        }
        rel_say(list ? "}" : ")");
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
/* The assignment of a field of a desc. */
static void rel_assign(const rel_scene *s, const rel_field *f, const rel_set *v) {
    int k;
    if ((f->type == REL_BODY || f->type == REL_REF) && v->v[0] < 0) return;        /* none, as by default */
    if (f->type == REL_INT3) for (k = 0; k < 3; k++) rel_say("%s[%d] = %d; ", f->name, k, (int)v->v[k]);
    else if (f->type == REL_REAL_ARRAY || f->type == REL_DOUBLE_ARRAY || f->type == REL_REF_ARRAY)
        for (k = 0; k < v->count; k++) {
            if (f->type == REL_REF_ARRAY && s->pool[v->at + k] < 0) continue;      /* a sphere, as by default */
            rel_say("%s[%d] = ", f->name, k);
            if (f->type == REL_REF_ARRAY) rel_name(s, (int)s->pool[v->at + k]);
            else rel_say("%s", rel_number(s->pool[v->at + k]));
            rel_say("; ");
        }
    else {
        rel_say("%s = ", f->name);
        rel_value(s, f, v);
        rel_say("; ");
    }
}
static void rel_desc(const rel_scene *s, const rel_op *op) {
    const rel_call *c = &rel_calls[op->call];
    int i;
    if (op->call == REL_PAIR) {
        rel_say("{ dem_pair d; dem_pair_get(w, ");
        rel_name(s, (int)rel_given(op, "a", 1)->v[0]);
        rel_say(", ");
        rel_name(s, (int)rel_given(op, "b", 1)->v[0]);
        rel_say(", &d); ");
    } else rel_say("{ %s d = %s; ", c->desc, c->zero);
    if (op->call == REL_CLUSTER)
        for (i = 0; i < op->count; i++) {
            const rel_field *f = &c->fields[op->set[i].field];
            if (f->type != REL_REALS) continue;
            if (!strcmp(f->name, "positions")) rel_say("d.count = %d; ", op->set[i].count/3);
            rel_say("d.%s = ", f->name);
            rel_value(s, f, &op->set[i]);
            rel_say("; ");
        }
    for (i = 0; i < op->count; i++)
        if (strchr(c->fields[op->set[i].field].name, '.')) rel_assign(s, &c->fields[op->set[i].field], &op->set[i]);
}
/* The text of a call: $name is a value, #name the length of a list. */
static void rel_text(const rel_scene *s, const rel_op *op) {
    const rel_call *c = &rel_calls[op->call];
    const char *p;
    for (p = c->text; *p; p++) {
        size_t n = 0;
        const rel_set *v;
        rel_set zero;
        int i;
        if (*p != '$' && *p != '#') { rel_say("%c", *p); continue; }
        while ((p[n + 1] >= 'a' && p[n + 1] <= 'z') || p[n + 1] == '_' || p[n + 1] == '.') n++;
        v = rel_given(op, p + 1, n);
        for (i = 0; i < c->field_count; i++)
            if (strlen(c->fields[i].name) == n && !strncmp(c->fields[i].name, p + 1, n)) break;
        if (*p == '#') rel_say("%d", v ? v->count : 0);
        else {
            memset(&zero, 0, sizeof zero);                 /* a field that is not set has its default */
            if (!v && c->defaults) {
                const char *at = (const char *)c->defaults + c->fields[i].at;
                int k;
                if (c->fields[i].type == REL_INT) zero.v[0] = *(const int *)at;
                if (c->fields[i].type == REL_TEXT) zero.v[0] = rel_text_of(*(const char *const *)(const void *)at);
                for (k = 0; k < (c->fields[i].type == REL_VEC ? 3 : c->fields[i].type == REL_REAL); k++)
                    zero.v[k] = (double)((const dem_real *)at)[k];
            }
            if (v || c->fields[i].type != REL_REALS) rel_value(s, &c->fields[i], v ? v : &zero);
            else rel_say("0");
        }
        p += n;
    }
}
/* Does a body need more than dem_sphere_add and dem_body_add? */
static int rel_moves(const rel_op *op) {
    const rel_set *v = rel_given(op, "velocity", 8), *o = rel_given(op, "spin", 4);
    static const double none[3] = {0, 0, 0};
    return (v && memcmp(v->v, none, sizeof none)) || (o && memcmp(o->v, none, sizeof none)) ||
        rel_given(op, "scale", 5);
}
static void rel_body_text(const rel_scene *s, const rel_op *op) {
    static const char *const names[] = {"material", "shape", "radius", "position", "velocity", "spin", "orientation"};
    const int shaped = rel_given(op, "shape", 5) != 0, moves = rel_moves(op);
    const rel_set *scale = rel_given(op, "scale", 5);
    int k;
    rel_say(moves ? (shaped ? "body(w" : "ball(w") : shaped ? "dem_body_add(w" : "dem_sphere_add(w");
    for (k = 0; k < (shaped ? 7 : 6); k++) {
        const rel_set *v = rel_given(op, names[k], strlen(names[k]));
        if (k == (shaped ? 2 : 1) || (!moves && (k == 4 || k == 5))) continue;
        rel_say(", ");
        if (v) rel_value(s, &rel_calls[op->call].fields[v->field], v);
        else rel_say(k == 2 ? "0" : k < 6 ? "V(0, 0, 0)" : "dem_quat_make(1, 0, 0, 0)");
    }
    if (shaped && moves) rel_say(", %s", rel_number(scale ? scale->v[0] : 1));
    rel_say(")");
}
static int rel_refers(const rel_scene *s, const rel_op *op, int to) {
    int j, k;
    for (j = 0; j < op->count; j++) {
        const rel_set *v = &op->set[j];
        const rel_type type = rel_calls[op->call].fields[v->field].type;
        if ((type == REL_REF || type == REL_BODY) && (int)v->v[0] == to) return 1;
        if (type == REL_REF_ARRAY) for (k = 0; k < v->count; k++) if ((int)s->pool[v->at + k] == to) return 1;
    }
    return 0;
}
static int rel_named = -1;                     /* a call whose results have variables in any case */
/* Has what the op makes a variable? */
static int rel_kept(const rel_scene *s, int at) {
    int i;
    for (i = 0; i < s->count; i++) if (rel_refers(s, &s->op[i], at)) return 1;
    return s->op[at].call == REL_A_BODY || s->op[at].call == rel_named;
}
/* Writes an op as a statement. kept: what it makes has a variable. */
static void rel_statement(const rel_scene *s, int at, int kept) {
    const rel_op *op = &s->op[at];
    const rel_call *c = &rel_calls[op->call];
    if (*c->desc) rel_desc(s, op);
    if (*c->makes && kept) {
        rel_name(s, at);
        rel_say(" = ");
    }
    if (op->call == REL_A_BODY) rel_body_text(s, op);
    else rel_text(s, op);
    rel_say(*c->desc ? "; }" : ";");
}
static int rel_uses(const rel_scene *s, int call) {
    int i;
    for (i = 0; i < s->count; i++) if (s->op[i].call == call) return 1;
    return 0;
}
/* Functions that the statements use. */
typedef struct rel_helper { int call, shaped; const char *lines[9]; } rel_helper;
static const rel_helper rel_helpers[] = {
    {REL_A_BODY, 0, {
        "static dem_body ball(dem_world *w, dem_material m, double r, dem_vec3 x, dem_vec3 v, dem_vec3 spin) {",
        "    const dem_body id = dem_sphere_add(w, m, r, x);", "    dem_body_state s;",
        "    if (dem_body_get(w, id, &s) != DEM_OK) return id;", "    s.velocity = v; s.spin = spin;",
        "    dem_body_set(w, id, &s);", "    return id;", "}", 0}},
    {REL_A_BODY, 1, {
        "static dem_body body(dem_world *w, dem_material m, dem_shape s, dem_vec3 x, dem_vec3 v, dem_vec3 spin,",
        "                     dem_quat q, dem_real scale) {", "    const dem_real turned[4] = {q.w, q.x, q.y, q.z};",
        "    dem_bodies_add(w, m, s, 1, &x.x, turned, &v.x, &spin.x, &scale);",
        "    return dem_body_id_get(w, dem_bodies_get(w).count - 1);", "}", 0, 0, 0}},
    {REL_MESH, 0, {
        "static dem_wall mesh(dem_world *w, dem_material m, int n, dem_real *x, int k, int32_t *t) {",
        "    dem_mesh a;", "    a.vertex_count = n; a.vertices = x; a.triangle_count = k; a.triangles = t;",
        "    return dem_wall_mesh_add(w, m, &a);", "}", 0, 0, 0, 0}},
    {REL_PROFILE, 0, {
        "static dem_wall profile(dem_world *w, dem_material m, int n, dem_real *x, int k, int32_t *t, int rule) {",
        "    dem_profile a;", "    a.vertex_count = n; a.vertices = x; a.segment_count = k; a.segments = t;",
        "    return dem_wall_profile_add(w, m, &a, rule);", "}", 0, 0, 0, 0}},
    {REL_TABLE, 0, {
        "static void table(dem_world *w, dem_wall wall, dem_motion *d, int n, const dem_real *t, const dem_real *x,",
        "                  const dem_real *q, const dem_real *load) {", "    dem_motion_row row[8];", "    int k;",
        "    for (k = 0; k < n; k++, x += 3, q += 4)",
        "        row[k] = (dem_motion_row){t[k], {x[0], x[1], x[2]}, {q[0], q[1], q[2], q[3]}, load[k]};",
        "    d->table = row; d->table_count = n;", "    dem_wall_motion_set(w, wall, d);", "}"}},
    {REL_FIX, 0, {
        "static void fix(dem_world *w, dem_body b, int fixed) {", "    dem_selection s = DEM_SELECTION;",
        "    s.count = 1; s.bodies = &b;", "    dem_bodies_fixed_set(w, &s, fixed);", "}", 0, 0, 0, 0}},
    {REL_MEMBER, 0, {
        "static void group(dem_world *w, dem_body b, const char *name, int member) {",
            "    dem_selection s = DEM_SELECTION;",
        "    s.count = 1; s.bodies = &b;", "    dem_bodies_group_set(w, &s, dem_group_get(w, name), member);", "}",
            0, 0, 0, 0}},
    {REL_REMOVE_SOME, 0, {
        "static void remove_some(dem_world *w, dem_body b) {", "    dem_selection s = DEM_SELECTION;",
        "    s.count = 1; s.bodies = &b;", "    dem_bodies_remove(w, &s);", "}", 0, 0, 0, 0}},
    {REL_KICK, 0, {
        "static void kick(dem_world *w, dem_body b, dem_vec3 v, dem_vec3 spin) {",
            "    dem_selection s = DEM_SELECTION;",
        "    s.count = 1; s.bodies = &b;", "    dem_bodies_velocity_set(w, &s, v, spin);", "}", 0, 0, 0, 0}}
};
static void rel_print_helpers(FILE *out, const rel_scene *s) {
    int i, k, h, call;
    for (h = 0; h < (int)(sizeof rel_helpers/sizeof *rel_helpers); h++) {
        for (i = 0; i < s->count; i++)
            if ((call = s->op[i].call == REL_MESH_FILE ? REL_MESH : s->op[i].call == REL_PROFILE_FILE ? REL_PROFILE :
                        s->op[i].call) == rel_helpers[h].call &&
                            (rel_given(&s->op[i], "shape", 5) != 0) == rel_helpers[h].shaped &&
                (call != REL_A_BODY || rel_moves(&s->op[i]))) break;
        for (k = 0; k < 9 && i < s->count && rel_helpers[h].lines[k]; k++)
            fprintf(out, "%s\n", rel_helpers[h].lines[k]);
    }
}
/* Where to break a text that has more than `room` characters: after a semicolon, before an argument that is no number,
   or after any comma. */
static int rel_break(const char *text, int room) {
    int k, kind;
    for (kind = 0; kind < 3; kind++)
        for (k = room; k > (kind < 2 ? room/2 : 1); k--) {
            if (text[k] != ' ' || (text[k - 1] != ';' && text[k - 1] != ',' && text[k - 1] != '{')) continue;
            if (kind == 2 || text[k - 1] == ';' || (kind == 1 && isalpha((unsigned char)text[k + 1]))) return k;
        }
    return (int)strlen(text);
}
static void rel_line(FILE *out, int indent, const char *text) {
    int first = 1;
    while (*text) {
        const int room = 112 - indent - (first ? 0 : 4);
        int n = (int)strlen(text);
        while (n > 0 && text[n - 1] == ' ') n--;
        if (n > room) n = rel_break(text, room);
        fprintf(out, "%*s%.*s\n", indent + (first ? 0 : 4), "", n, text);
        for (text += n; *text == ' '; text++) continue;
        first = 0;
    }
}
#endif
