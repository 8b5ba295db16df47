/* relate_images.h - relations of rounding: another way to find contacts, and images of a scene: turned, mirrored,
   moved, in other units or in another order. */
#ifndef REL_RELATE_IMAGES_H
#define REL_RELATE_IMAGES_H
#include "edit.h"

static int rel_search(rel_case *c) {
    static const int kinds[] = {DEM_SEARCH_ALL_PAIRS, DEM_SEARCH_GRID, DEM_SEARCH_LINKED_LIST, DEM_SEARCH_HIERARCHICAL,
                                DEM_SEARCH_BINS};
    if (!c->ran) return REL_SKIPPED;
    return rel_with(c, "search", kinds[rel_below(&c->rng, 5)], "another search");
}
static int rel_skin(rel_case *c) {
    static const double skins[] = {-1, 1e-5, 1e-4, 5e-4};
    int result;
    if (!c->ran) return REL_SKIPPED;
    c->lists = 1;
    result = rel_with(c, "skin", skins[rel_below(&c->rng, 4)], "another skin");
    c->lists = 0;
    return result;
}
static int rel_slabs(rel_case *c) {
    rel_how how = {0};
    rel_run other;
    int ran, result = REL_HOLDS;
    if (!c->ran) return REL_SKIPPED;
    how.slabs = 1 + rel_below(&c->rng, 3);
    how.axis = rel_below(&c->rng, rel_has(c, "planar") ? 2 : 3);
    how.moved = rel_below(&c->rng, 2);
    ran = c->other_ran = rel_go(&other, c->s, &how);
    c->how = how;
    c->lists = 1;
    if (other.refused < 0) result = REL_SKIPPED;           /* by name: counted elsewhere */
    else if (!ran && !other.refused) result = rel_broken(c, "%d slabs: %s", how.slabs, other.message);
    else if (ran) result = rel_compare(c, &other, &rel_same,
                                       how.slabs == 1 ? "1 slab" : how.slabs == 2 ? "2 slabs" : "3 slabs");
    c->lists = 0;
    rel_end(&other);
    return result;
}
/* ---- images of the scene ---- */
static void rel_turn(const rel_map *m, const double *x, double *to, double sign) {
    double y[3];
    int i, k;
    for (i = 0; i < 3; i++) for (y[i] = 0, k = 0; k < 3; k++) y[i] += m->m[i][k]*x[k]*sign;
    memcpy(to, y, sizeof y);
}
/* The locked axes of a rail. */
static int rel_turn_axes(const rel_map *m, int axes) {
    int i, k, to = 0;
    for (i = 0; i < 3; i++)
        for (k = 0; k < 3; k++)
            if (fabs(m->m[i][k]) > 0.5) to |= (axes >> k & 1) << i | (axes >> (3 + k) & 1) << (3 + i);
    return to;
}
/* The image of a scene under a map. */
static void rel_map_scene(rel_scene *to, const rel_scene *from, const rel_map *m) {
    int i, j, k, e;
    rel_copy(to, from);
    for (i = 0; i < to->count; i++) {
        rel_op *op = &to->op[i];
        const rel_set *area = op->call == REL_MOTION || op->call == REL_TABLE ? rel_given_in(op, "area") : 0;
        for (j = 0; j < rel_calls[op->call].field_count; j++) {    /* points and directions at defaults move, too */
            const rel_field *f = &rel_calls[op->call].fields[j];
            const char *defaults = (const char *)rel_calls[op->call].defaults;
            dem_vec3 x = {0, 0, 0};
            if (f->nature == REL_ORIENTATION && rel_given_in(op, "shape") && !rel_find(op, f->name))
                rel_slot(op, f->name)->v[0] = 1;           /* the axes of a shape have directions */
            if (f->type != REL_VEC || (f->nature != REL_POINT && f->nature != REL_VECTOR && f->nature != REL_AXIAL) ||
                rel_find(op, f->name)) continue;
            if (defaults) memcpy(&x, defaults + f->at, sizeof x);
            if (f->nature == REL_POINT || fabs((double)x.x) + fabs((double)x.y) + fabs((double)x.z) > 0)
                rel_put3(op, f->name, (double)x.x, (double)x.y, (double)x.z);
        }
        for (j = 0; j < op->count; j++) {
            rel_set *v = &op->set[j];
            const rel_field *f = &rel_calls[op->call].fields[v->field];
            /* with an area, the load of a servo is a stress (dem_motion.load) */
            const int stress = (!strcmp(f->name, "d.load") || !strcmp(f->name, "loads")) && area && area->v[0] > 0;
            const double unit = pow(m->length, f->length - 2*stress)*pow(m->mass, f->mass)*pow(m->time, f->time);
            const int list = f->type == REL_REALS, array = f->type == REL_REAL_ARRAY || f->type == REL_DOUBLE_ARRAY;
            double *x = v->v;
            if (f->nature == REL_AXES) { x[0] = rel_turn_axes(m, (int)x[0]); continue; }
            if (f->type == REL_INT || f->type == REL_REF || f->type == REL_BODY || f->type == REL_INTS ||
                f->type == REL_REF_ARRAY || (f->type >= REL_CODE && f->type <= REL_WHOLE)) continue;
            if (list || array) {
                x = to->pool + v->at;
                for (k = 0; k < v->count; k++) x[k] *= unit;
            } else for (k = 0; k < 6 && f->type != REL_INT3; k++) x[k] *= unit;
            if ((op->call == REL_MOTION || op->call == REL_TABLE) && !strcmp(f->name, "d.speed")) x[0] *= m->det;
            for (k = 0; list && k + 4 <= v->count; k += 4)
                if (f->nature == REL_TURN || (f->nature == REL_TURN_IN_BODY && m->det < 0))
                    rel_turn(m, x + k + 1, x + k + 1, m->det);
            for (k = 0; k + 3 <= (list ? v->count : 3); k += 3) {
                if (f->nature == REL_POINT && f->type != REL_BOX) {
                    rel_turn(m, x + k, x + k, 1);
                    for (e = 0; e < 3; e++) x[k + e] += m->to[e];
                }
                if (f->nature == REL_VECTOR) rel_turn(m, x + k, x + k, 1);
                if (f->nature == REL_AXIAL) rel_turn(m, x + k, x + k, m->det);
                if (f->nature == REL_IN_BODY && m->det < 0) rel_turn(m, x + k, x + k, 1);
            }
            for (k = 0; list && k + 2 <= v->count; k += 2) {
                double y[3];
                if (f->nature != REL_POINT_2 && !(f->nature == REL_IN_BODY_2 && m->det < 0)) break;
                y[0] = x[k]; y[1] = x[k + 1]; y[2] = 0;
                rel_turn(m, y, y, 1);
                for (e = 0; e < 2; e++) x[k + e] = y[e] + (f->nature == REL_POINT_2 ? m->to[e] : 0);
            }
            if (f->nature == REL_PER_AXIS) {
                double y[3];
                for (e = 0; e < 3; e++) for (y[e] = 0, k = 0; k < 3; k++) y[e] += fabs(m->m[e][k])*x[k];
                memcpy(x, y, sizeof y);
            }
            if (f->type == REL_BOX) {
                double lo[3], hi[3];
                rel_turn(m, x, lo, 1);
                rel_turn(m, x + 3, hi, 1);
                for (e = 0; e < 3; e++) {
                    x[e] = fmin(lo[e], hi[e]) + m->to[e];
                    x[3 + e] = fmax(lo[e], hi[e]) + m->to[e];
                }
            }
            if (f->nature == REL_ORIENTATION) {
                if (m->det < 0) rel_turn(m, x + 1, x + 1, -1);
                else {                          /* the rotation of the axes, then its own */
                    const double w = sqrt(fmax(0, 1 + m->m[0][0] + m->m[1][1] + m->m[2][2]))/2;
                    if (w > 0.1) {
                        const double a = (m->m[2][1] - m->m[1][2])/(4*w), b = (m->m[0][2] - m->m[2][0])/(4*w),
                                     d = (m->m[1][0] - m->m[0][1])/(4*w), q0 = x[0], q1 = x[1], q2 = x[2], q3 = x[3];
                        x[0] = w*q0 - a*q1 - b*q2 - d*q3;
                        x[1] = w*q1 + a*q0 + b*q3 - d*q2;
                        x[2] = w*q2 - a*q3 + b*q0 + d*q1;
                        x[3] = w*q3 + a*q2 - b*q1 + d*q0;
                    }
                }
            }
        }
    }
}
static int rel_code_flag(const rel_case *c, int turned) {
    int i, j;
    for (i = 0; i < c->s->count; i++)
        for (j = 0; j < c->s->op[i].count; j++)
            if (rel_calls[c->s->op[i].call].fields[c->s->op[i].set[j].field].type == REL_CODE) {
                const rel_code *code = &rel_codes[(int)c->s->op[i].set[j].v[0]];
                if (turned ? !code->turned : !code->scaled) return 1;
            }
    return 0;
}
/* Leaves out outlets whose region is in the frame of a wall (dem_outlet_desc.box: "in that frame"): an image would have
   to move it with the frame of the other wall. */
static void rel_leave_framed(rel_scene *s) {
    int i;
    for (i = s->count - 1; i > 0; i--)
        if (i < s->count && s->op[i].call == REL_OUTLET && rel_find(&s->op[i], "d.frame")) rel_drop_ops(s, i, i + 1);
}
/* Leaves out what has axes or a direction of its own, or draws random places: feeds, the shear of a cell, user-defined
   motions. convex: the image has the contact points of polyhedra in another order. By impulses their loads are "one of
   many solutions" (docs/impulses.md) if there are more than three, and friction by Coulomb's law depends on each; the
   convex law is a quadratic programme, whose velocities are unique. */
static int rel_leave_axes(rel_case *c, int convex) {
    static const int feeds[] = {REL_FEED, REL_FEED_SIZES, REL_FILL, REL_FILL_SHAPE, -1};
    static const char *const shear[] = {"shear", 0};
    /* what is beyond a distance from the z axis of a frame; a cylinder along an axis */
    static const char *const without[] = {"outlet beyond", "push in a cylinder", 0};
    int i;
    if (rel_has_any(c, without)) return 0;
    rel_copy(&rel_own, c->s);
    rel_leave_calls(&rel_own, feeds, 0);
    rel_leave_fields(&rel_own, REL_CELL, shear);
    rel_leave_framed(&rel_own);
    for (i = rel_own.count - 1; i > 0; i--)
        if (rel_own.op[i].call == REL_MOTION && rel_find(&rel_own.op[i], "function")) rel_drop_ops(&rel_own, i, i + 1);
    for (i = 0; i < rel_own.count && convex && rel_has(c, "impulses"); i++)
        if (rel_own.op[i].call == REL_POLYHEDRON) rel_put(&rel_own.op[0], "cone", DEM_CONE_CONVEX);
    return rel_instead(c) && !rel_code_flag(c, 1);
}
static int rel_image_near(rel_case *c, const rel_map *map, const char *what) {
    const rel_how how = {0};
    rel_map_scene(&rel_image, c->s, map);
    return rel_near(c, &rel_image, &how, map, what);
}
static int rel_rotated(rel_case *c) {
    rel_map m = rel_same;
    const int axis = rel_has(c, "planar") || rel_has(c, "profile") ? 2 : rel_below(&c->rng, 3), x = (axis + 1)%3,
        y = (axis + 2)%3;
    if (!c->ran || !rel_leave_axes(c, 0)) return REL_SKIPPED;
    m.m[x][x] = m.m[y][y] = 0;
    m.m[x][y] = -1;
    m.m[y][x] = 1;
    return rel_image_near(c, &m, axis == 0 ? "rotated about x" : axis == 1 ? "rotated about y" : "rotated about z");
}
static int rel_mirrored(rel_case *c) {
    rel_map m = rel_same;
    const int axis = rel_below(&c->rng, rel_has(c, "planar") ? 2 : 3);
    if (!c->ran || !rel_leave_axes(c, 1)) return REL_SKIPPED;
    m.m[axis][axis] = -1;
    m.det = -1;
    return rel_image_near(c, &m, axis == 0 ? "mirrored in x" : axis == 1 ? "mirrored in y" : "mirrored in z");
}
static int rel_translated(rel_case *c) {
    static const char *const without[] = {"outlet beyond", "push inside", "feed inside", 0};
    const double far = rel_below(&c->rng, 2) ? 16 : 1;     /* walls are not faster there */
    rel_map m = rel_same;
    if (!c->ran || rel_has_any(c, without)) return REL_SKIPPED;
    rel_copy(&rel_own, c->s);
    rel_leave_framed(&rel_own);
    if (!rel_instead(c)) return REL_SKIPPED;
    m.to[0] = ldexp(far, -6);
    m.to[1] = -ldexp(far, -7);
    if (!rel_has(c, "planar")) m.to[2] = ldexp(far, -5);
    return rel_image_near(c, &m, "translated");
}
/* Leaves out what is at rest, moves as prescribed, or depends on velocities: all but walls and bodies alone. What
   joints may do depends on the kinetic energy of what they join (docs/impulses.md). */
static int rel_leave_frame(rel_case *c, double faster /* m/s */) {
    static const int without[] = {REL_MOTION, REL_TABLE, REL_FIX, REL_FEED, REL_FEED_SIZES, REL_FILL, REL_FILL_SHAPE,
        REL_SPHERES, REL_TEMPERATURE, REL_PUSH, REL_OUTLET, REL_RAIL, REL_CELL, REL_FIELD,
        REL_WALL_REMOVE, REL_JOINT, -1};
    static const char *const fields[] = {"force", "body_force", "domain", "boundary", 0};
    double speed = 0;
    int k;
    for (k = 0; k < c->base.marks; k++) speed = fmax(speed, c->base.mark[k].speed);
    rel_copy(&rel_own, c->s);
    rel_leave_calls(&rel_own, without, 0);
    rel_leave_fields(&rel_own, REL_WORLD, fields);
    /* 0: from the speed of the fastest body. A step fails if a body moves farther than half of it, and bodies are
       faster in the image; marks do not see the speeds of all steps. */
    if (rel_has(c, "impulses"))
        rel_put(&rel_own.op[0], "law_range", fmax(5e-4, 3*(speed + faster)*(double)dem_counters_get(c->base.w).dt));
    return rel_instead(c);
}
static int rel_galilei(rel_case *c) {
    const double V[3] = {0.125, -0.0625, rel_has(c, "planar") ? 0 : 0.25};
    const rel_how how = {0};
    rel_map m = rel_same;
    int i, k;
    if (!c->ran || !rel_leave_frame(c, sqrt(V[0]*V[0] + V[1]*V[1] + V[2]*V[2]))) return REL_SKIPPED;
    rel_copy(&rel_image, c->s);
    for (i = 0; i < c->s->count; i++) {
        rel_op *op = &rel_image.op[i];
        if (op->call == REL_A_BODY || op->call == REL_KICK) {
            rel_set *v = rel_find(op, "velocity");
            if (!v) v = rel_slot(op, "velocity");
            for (k = 0; k < 3; k++) v->v[k] += V[k];
        }
        if (rel_is_wall(op->call)) {
            rel_op *move = rel_more(&rel_image, REL_MOTION, 0);
            rel_put(move, "wall", i);
            rel_put(move, "kind", DEM_MOTION_TRANSLATING);
            rel_put3(move, "velocity", V[0], V[1], V[2]);
        }
    }
    for (k = 0; k < 3; k++) m.drift[k] = V[k];
    return rel_near(c, &rel_image, &how, &m, "with a constant velocity");
}
static int rel_scaled(rel_case *c) {
    const rel_how how = {0};
    rel_map m = rel_same;
    rel_run other;
    int k, i, e, ran, result = REL_HOLDS;
    /* products of what is larger do not underflow */
    const double least = sizeof(dem_real) == sizeof(double) ? 1e-100 : 1e-20;
    /* "F in N and w in rad/s compared as printed there" (dem_law_roll_step) */
    if (!c->ran || rel_code_flag(c, 0) || rel_has(c, "step rolling")) return REL_SKIPPED;
    rel_copy(&rel_own, c->s);
    rel_fit_units(&rel_own);
    if (!rel_instead(c)) return REL_SKIPPED;
    /* square, cube and fourth roots of these are exact */
    m.length = ldexp(1, 12*rel_below(&c->rng, 3) - 12);
    m.time = ldexp(1, 4*rel_below(&c->rng, 3) - 4);
    m.mass = ldexp(1, 4*rel_below(&c->rng, 5) - 8);
    rel_map_scene(&rel_image, c->s, &m);
    rel_image.unit[0] = m.length;
    rel_image.unit[1] = m.time;
    if ((rel_has(c, "linear") || rel_has(c, "hysteretic") || rel_has(c, "own law") || rel_has(c, "law by rows") ||
         rel_has(c, "law of stages") || rel_has(c, "rules of the mill")) && !rel_has(c, "stiffness"))
        return rel_near(c, &rel_image, &how, &m, "in other units");     /* fifth roots are rounded */
    ran = c->other_ran = rel_go(&other, &rel_image, &how);
    c->image = &rel_image;
    c->map = m;
    if (!ran) result = rel_broken(c, "lengths times %g, masses times %g, times times %g: %s", m.length, m.mass,
                                  m.time, other.message);
    for (k = 0; k < other.marks && k < c->base.marks && result == REL_HOLDS; k++)
        for (i = 0; i < c->base.mark[k].bodies && result == REL_HOLDS; i++)
            for (e = 0; e < 9; e++) {          /* velocities that decay may underflow (DEMI_TINY) */
                const double unit = e < 3 ? m.length : e < 6 ? m.length/m.time : 1/m.time;
                const double a = c->base.mark[k].x[REL_PER_BODY*i + e]*unit, b = other.mark[k].x[REL_PER_BODY*i + e];
                if ((a < b || a > b) && fmax(fabs(a), fabs(b))/unit > least) {
                    result = rel_broken(c, "lengths times %g, masses times %g, times times %g: %s of body %d at step "
                                        "%d is %.17g, not %.17g", m.length, m.mass, m.time,
                                        e < 3 ? "the position" : e < 6 ? "the velocity" : "the spin", i,
                                        c->base.mark[k].step, b/unit, a/unit);
                    break;
                }
            }
    rel_end(&other);
    return result;
}
static int rel_moves_wall(int call) { return call == REL_MOTION || call == REL_TABLE || call == REL_BELT; }
/* Exchanges the values of two ops of one kind, and all references to them. */
static void rel_exchange(rel_scene *s, int a, int b) {
    const rel_op op = s->op[a];
    int i, j;
    s->op[a] = s->op[b];
    s->op[b] = op;
    for (i = 0; i < s->count; i++)
        for (j = 0; j < s->op[i].count; j++) {
            rel_set *v = &s->op[i].set[j];
            const rel_type type = rel_calls[s->op[i].call].fields[v->field].type;
            if (type != REL_REF && type != REL_BODY) continue;
            if ((int)v->v[0] == a) v->v[0] = b;
            else if ((int)v->v[0] == b) v->v[0] = a;
        }
}
/* The plane of element k of a wall: its normal and its distance from the origin; 0: it has no such element. */
static int rel_wall_plane(const rel_scene *s, const rel_op *wall, int k, double *plane) {
    const int flat = wall->call == REL_PLANE, per = wall->call == REL_MESH ? 3 : 2;
    const rel_set *n = flat ? rel_given_in(wall, "normal") : 0, *o = flat ? rel_given_in(wall, "point") : 0, *v, *t;
    double x[3][3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, e[2][3], size = 0;
    int i, q;
    for (q = 0; q < 4; q++) plane[q] = 0;
    for (q = 0; q < 3 && n && !k; q++) { plane[q] = n->v[q]; x[0][q] = o ? o->v[q] : 0; }
    if (!flat) {
        if (wall->call != REL_MESH && wall->call != REL_PROFILE) return 0;
        v = rel_given_in(wall, "vertices");
        t = rel_given_in(wall, "triangles");
        if (!v || !t || per*k >= t->count) return 0;
        for (i = 0; i < per; i++)
            for (q = 0; q < per; q++) x[i][q] = s->pool[v->at + per*(int)s->pool[t->at + per*k + i] + q];
        if (per == 2) { x[2][0] = x[0][0]; x[2][1] = x[0][1]; x[2][2] = 1; }
        for (q = 0; q < 3; q++) { e[0][q] = x[1][q] - x[0][q]; e[1][q] = x[2][q] - x[0][q]; }
        for (q = 0; q < 3; q++) plane[q] = e[0][(q + 1)%3]*e[1][(q + 2)%3] - e[0][(q + 2)%3]*e[1][(q + 1)%3];
    }
    for (q = 0; q < 3; q++) size += plane[q]*plane[q];
    for (q = 0; q < 3 && size > 0; q++) plane[3] += (plane[q] /= sqrt(size))*x[0][q];
    return size > 0;
}
static int rel_wall_is_moved(const rel_scene *s, int wall) {
    int i;
    for (i = 0; i < s->count; i++) {
        const rel_set *of = rel_moves_wall(s->op[i].call) ? rel_given_in(&s->op[i], "wall") : 0;
        if (of && (int)of->v[0] == wall) return 1;
    }
    return 0;
}
/* "Where two such surfaces coincide, only the wall that was added first acts" (docs/theory_surfaces.md, of surfaces
   that move against each other; of planes and facets at rest it says the same). Do elements of two walls, of which one
   moves or has another material, lie in the same plane? */
static int rel_walls_coincide(const rel_scene *s, int a, int b) {
    const rel_set *one, *other;
    double p[4], q[4];
    int i, k, e;
    if (!rel_wall_plane(s, &s->op[a], 0, p) || !rel_wall_plane(s, &s->op[b], 0, q)) return 0;
    one = rel_given_in(&s->op[a], "material");
    other = rel_given_in(&s->op[b], "material");
    if (!rel_wall_is_moved(s, a) && !rel_wall_is_moved(s, b) && one && other && (int)one->v[0] == (int)other->v[0])
        return 0;
    for (i = 0; rel_wall_plane(s, &s->op[a], i, p); i++)
        for (k = 0; rel_wall_plane(s, &s->op[b], k, q); k++) {
            const double way = p[0]*q[0] + p[1]*q[1] + p[2]*q[2] < 0 ? -1 : 1;
            for (e = 0; e < 4 && fabs(p[e] - way*q[e]) < 1e-9; e++) continue;
            if (e == 4) return 1;
        }
    return 0;
}
/* Feeds draw places in the order of the bodies that are there. */
static int rel_order(rel_case *c, int walls) {
    static const int feeds[] = {REL_FEED, REL_FEED_SIZES, REL_FILL, REL_FILL_SHAPE, -1};
    const rel_how how = {0};
    rel_run other;
    int at[REL_OPS], n = 0, i, k, e, ran, result = REL_HOLDS;
    if (!c->ran) return REL_SKIPPED;
    rel_copy(&rel_own, c->s);
    rel_leave_calls(&rel_own, feeds, 0);
    /* other solvers find the same velocities with the convex law only (docs/impulses.md) */
    if (rel_has(c, "impulses")) rel_put(&rel_own.op[0], "cone", DEM_CONE_CONVEX);
    if (!rel_instead(c)) return REL_SKIPPED;
    rel_copy(&rel_image, c->s);
    for (i = 0; i < c->s->count && !(walls && rel_moves_wall(c->s->op[i].call)); i++)
        if (walls ? rel_is_wall(c->s->op[i].call) && !c->s->op[i].step : c->s->op[i].call == REL_A_BODY) at[n++] = i;
    if (n < 2) return REL_SKIPPED;
    for (i = 0; i < n && walls; i++)
        for (k = 0; k < i; k++) if (rel_walls_coincide(c->s, at[i], at[k])) return REL_SKIPPED;
    for (i = 0; i < n/2; i++) rel_exchange(&rel_image, at[i], at[n - 1 - i]);
    if (walls) return rel_near(c, &rel_image, &how, &rel_same, "walls in another order");
    ran = c->other_ran = rel_go(&other, &rel_image, &how);
    c->image = &rel_image;
    c->reversed = 1;
    if (!ran && !other.failed) result = rel_broken(c, "bodies in another order: %s", other.message);
    for (k = 0; k < other.marks; k++)          /* back into the order of the base */
        for (i = 0; i < n/2; i++)
            for (e = 0; e < REL_PER_BODY; e++) {
                double *x = other.mark[k].x, y = x[REL_PER_BODY*i + e];
                x[REL_PER_BODY*i + e] = x[REL_PER_BODY*(n - 1 - i) + e];
                x[REL_PER_BODY*(n - 1 - i) + e] = y;
            }
    if (result == REL_HOLDS) result = rel_compare(c, &other, &rel_same, "bodies in another order");
    rel_end(&other);
    return result;
}
static int rel_body_order(rel_case *c) { return rel_order(c, 0); }
static int rel_wall_order(rel_case *c) { return rel_order(c, 1); }
/* ---- walls divided otherwise ---- */
static int rel_cut(rel_case *c) {
    static double x[3*600], t[3*1600];
    const rel_how how = {0};
    rel_op *op;
    rel_set *v, *f;
    int i, k, e, n;
    for (i = 0; i < c->s->count && c->s->op[i].call != REL_MESH; i++) continue;
    if (!c->ran || i == c->s->count) return REL_SKIPPED;
    rel_copy(&rel_image, c->s);
    op = &rel_image.op[i];
    v = rel_find(op, "vertices");
    f = rel_find(op, "triangles");
    n = v->count/3;
    if (n + f->count > 600 || rel_image.pool_count + 3*n + 7*f->count > REL_POOL) return REL_SKIPPED;
    memcpy(x, rel_image.pool + v->at, (size_t)v->count*sizeof *x);
    for (k = 0; k < f->count/3; k++) {
        const double *c3 = rel_image.pool + f->at + 3*k;
        int mid[3], a[3];
        for (e = 0; e < 3; e++) a[e] = (int)c3[e];
        for (e = 0; e < 3; e++) {
            int q;
            double p[3];
            for (q = 0; q < 3; q++) p[q] = (x[3*a[e] + q] + x[3*a[(e + 1)%3] + q])/2;
            for (q = 0; q < n && memcmp(x + 3*q, p, sizeof p); q++) continue;
            mid[e] = q;
            if (q == n) memcpy(x + 3*n++, p, sizeof p);
        }
        {
            const int four[12] = {a[0], mid[0], mid[2], mid[0], a[1], mid[1], mid[2], mid[1], a[2], mid[0], mid[1],
                mid[2]};
            for (e = 0; e < 12; e++) t[12*k + e] = four[e];
        }
    }
    k = f->count;
    v->at = rel_image.pool_count;
    v->count = 3*n;
    memcpy(rel_image.pool + v->at, x, (size_t)v->count*sizeof *x);
    f->at = v->at + v->count;
    f->count = 4*k;
    memcpy(rel_image.pool + f->at, t, (size_t)f->count*sizeof *t);
    rel_image.pool_count = f->at + f->count;
    return rel_near(c, &rel_image, &how, &rel_same, "each triangle cut into four");
}
static int rel_several(rel_case *c) {
    const rel_how how = {0};
    rel_op *op, *more;
    rel_set *f;
    int i, k, at, count = c->s->count;
    for (i = 0; i < count && c->s->op[i].call != REL_MESH; i++) continue;
    if (!c->ran || i == count) return REL_SKIPPED;
    rel_copy(&rel_image, c->s);
    op = &rel_image.op[i];
    f = rel_find(op, "triangles");
    if (f->count < 6) return REL_SKIPPED;
    more = &rel_image.op[rel_image.count++];
    *more = *op;
    at = rel_image.count - 1;
    k = f->count/6*3;
    rel_find(more, "triangles")->at = f->at + k;
    rel_find(more, "triangles")->count = f->count - k;
    f->count = k;
    for (k = 0; k < count; k++) {              /* what moves the one moves the other */
        rel_set *wall;
        if (!rel_moves_wall(rel_image.op[k].call) && rel_image.op[k].call != REL_WALL_REMOVE) continue;
        wall = rel_find(&rel_image.op[k], "wall");
        if (!wall || (int)wall->v[0] != i || rel_image.count >= REL_OPS) continue;
        rel_image.op[rel_image.count] = rel_image.op[k];
        rel_find(&rel_image.op[rel_image.count++], "wall")->v[0] = at;
    }
    return rel_near(c, &rel_image, &how, &rel_same, "a mesh as two walls");
}
/* "A wall whose motion has not begun, or whose speed is 0, is at rest" (docs/theory_surfaces.md). */
static int rel_not_begun(rel_case *c) {
    const rel_how how = {0};
    rel_op *m;
    int i;
    for (i = 0; i < c->s->count; i++)
        if (rel_is_wall(c->s->op[i].call) && !c->s->op[i].step && !rel_wall_is_moved(c->s, i)) break;
    if (!c->ran || i == c->s->count) return REL_SKIPPED;
    rel_copy(&rel_image, c->s);
    m = rel_more(&rel_image, REL_MOTION, 0);
    rel_put(m, "wall", i);
    rel_put(m, "kind", DEM_MOTION_TRANSLATING);
    rel_put3(m, "velocity", 0, 0.1, 0);
    rel_put(m, "start", 1000);
    return rel_near(c, &rel_image, &how, &rel_same, "with a motion that has not begun");
}
/* ---- belts ---- */
/* Gives a wall a motion that leaves it where it is. */
static void rel_stay(rel_scene *s, int wall) {
    static const double rows[2][12] = {{0, 1, 0, 0, 0, 0, 0, 0}, {1, 0, 0, 0, 1, 0, 0, 0}};
    static const struct { const char *name; int row, at, count; } lists[] = {
        {"times", 0, 0, 2}, {"places", 0, 2, 6}, {"turns", 1, 0, 8}, {"loads", 0, 2, 2}};
    rel_op *op = rel_more(s, REL_TABLE, 0);
    int i;
    rel_put(op, "wall", wall);
    rel_put(op, "kind", DEM_MOTION_TABLE);
    for (i = 0; i < 4; i++) {
        rel_set *v = rel_slot(op, lists[i].name);
        if (s->pool_count + lists[i].count > REL_POOL) exit(3);
        v->count = lists[i].count;
        v->at = s->pool_count;
        memcpy(s->pool + v->at, rows[lists[i].row] + lists[i].at, (size_t)v->count*sizeof *s->pool);
        s->pool_count += v->count;
    }
}
/* A plane that moves in itself and a plane at rest whose surface moves push grains in the same way. "The contact
   history crosses seams" between walls at rest relative to each other, and surfaces that move against each other "are
   not joined" (docs/theory_surfaces.md). So the belt has a motion, too: a table that leaves it where it is. */
static int rel_belt_or_wall(rel_case *c) {
    /* which may follow a wall */
    static const int moves[] = {REL_MOTION, REL_TABLE, REL_BELT, REL_RAIL, REL_OUTLET, REL_JOINT, -1};
    const rel_how how = {0};
    const rel_set *n;
    rel_op *op;
    double u[3] = {0.2, -0.1, 0.15}, along = 0, size = 0;
    int i, k;
    if (!c->ran) return REL_SKIPPED;
    rel_copy(&rel_own, c->s);
    rel_leave_calls(&rel_own, moves, 0);
    for (i = 0; i < rel_own.count && !(rel_own.op[i].call == REL_PLANE && !rel_own.op[i].step); i++) continue;
    n = i < rel_own.count ? rel_find(&rel_own.op[i], "normal") : 0;
    if (!n) return REL_SKIPPED;
    if (rel_has(c, "planar")) u[2] = 0;
    for (k = 0; k < 3; k++) { along += u[k]*n->v[k]; size += n->v[k]*n->v[k]; }
    for (k = 0; k < 3; k++) u[k] -= along*n->v[k]/size;
    rel_copy(&rel_image, &rel_own);
    op = rel_more(&rel_own, REL_BELT, 0);
    rel_put(op, "wall", i);
    rel_put3(op, "velocity", u[0], u[1], u[2]);
    rel_stay(&rel_own, i);
    if (!rel_instead(c) || !c->base.wall_contacts) return REL_SKIPPED;
    rel_put(&rel_image.op[0], "dt", rel_find(&rel_own.op[0], "dt")->v[0]);
    op = rel_more(&rel_image, REL_MOTION, 0);
    rel_put(op, "wall", i);
    rel_put(op, "kind", DEM_MOTION_TRANSLATING);
    rel_put3(op, "velocity", u[0], u[1], u[2]);
    return rel_near(c, &rel_image, &how, &rel_same, "a plane that moves in itself instead of a belt");
}
#endif
