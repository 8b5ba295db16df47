/* ---------------------------------------------------------------------------------------------
   >>gaps
   How far two convex bodies are apart, or how deep in each other, and the points by which they keep
   each other off: what impulses, and laws that reach beyond touch, ask of polyhedra. Geometry only,
   told by corners: for x of body A and y of body B the differences y - x fill a polytope D; the two
   touch where D has the origin in it, and the point of D's surface nearest to the origin tells gap
   and normal. Apart, it is reached over simplexes of D's corners, each step adding the one farthest
   towards the origin [GJK88]; overlapping, a polytope of such corners grows about the origin until
   its face nearest to the origin is one of D's [BER03]: the least way that parts the two. Both end
   at a corner that is there already, so that no tolerance decides but that of rounding; normals are
   those of faces of D, not of the short vector to the origin, and hold where a gap is 0. Where a
   face of one lies square to the normal, the other's is cut to its outline; no more than four of
   those points are the contact. Checked against all separating planes, and against portals, by
   tests/contact/test_convex.c.
   --------------------------------------------------------------------------------------------- */

/* A corner of D: B's corner b less A's corner a. */
typedef struct demi_lead { double x[3]; int a, b; } demi_lead;
/* Corners of D; the point nearest to the origin is the sum of part x, parts are 1 in all. */
typedef struct demi_simplex { int count; demi_lead at[4]; double part[4]; } demi_simplex;

/* The corner of a body that is farthest along n. */
static int demi_solid_far(const demi_solid *s, const double *n) {
    double most = -1e300;
    int i, far = 0;
    for (i = 0; i < s->corners; i++) {
        const double d = demi_dot3(n, s->corner[i]);
        if (d > most) { most = d; far = i; }
    }
    return far;
}
/* The corner of D that is farthest along n. */
static void demi_lead_along(const demi_solid *a, const demi_solid *b, const double *n,
                            demi_lead *out) {
    const double back[3] = {-n[0], -n[1], -n[2]};
    out->a = demi_solid_far(a, back);
    out->b = demi_solid_far(b, n);
    demi_sub3(b->corner[out->b], a->corner[out->a], out->x);
}
/* Parts of the corners of a segment, or of a triangle, in its point nearest to the origin. */
static void demi_near_segment(const double *p, const double *q, double *part) {
    double e[3], t;
    demi_sub3(q, p, e);
    t = -demi_dot3(p, e)/demi_dot3(e, e);
    t = t > 0 ? t < 1 ? t : 1 : 0;              /* 0 of a point */
    part[0] = 1 - t;
    part[1] = t;
}
static void demi_near_triangle(const double *p, const double *q, const double *r, double *part) {
    const double *corner[3];
    double e[3], f[3], n[3], ep, fp, eq, fq, er, fr, a, b, c;
    int i, k;
    corner[0] = p; corner[1] = q; corner[2] = r;
    part[0] = part[1] = part[2] = 0;
    demi_sub3(q, p, e);
    demi_sub3(r, p, f);
    demi_cross3(e, f, n);
    ep = -demi_dot3(e, p); fp = -demi_dot3(f, p);
    eq = -demi_dot3(e, q); fq = -demi_dot3(f, q);
    er = -demi_dot3(e, r); fr = -demi_dot3(f, r);
    a = eq*fr - er*fq;                          /* areas over the sides opposite to p, q and r */
    b = er*fp - ep*fr;
    c = ep*fq - eq*fp;
    if (!(demi_dot3(n, n) > 1e-16*demi_dot3(e, e)*demi_dot3(f, f))) {   /* a line */
        double least = 1e300;
        for (i = 0; i < 3; i++) {
            const double *from = corner[i], *to = corner[(i + 1)%3];
            double t[2], x[3];
            demi_near_segment(from, to, t);
            for (k = 0; k < 3; k++) x[k] = t[0]*from[k] + t[1]*to[k];
            if (!(demi_dot3(x, x) < least)) continue;
            least = demi_dot3(x, x);
            part[i] = t[0];
            part[(i + 1)%3] = t[1];
            part[(i + 2)%3] = 0;
        }
    } else if (ep <= 0 && fp <= 0) part[0] = 1;
    else if (eq >= 0 && fq <= eq) part[1] = 1;
    else if (fr >= 0 && er <= fr) part[2] = 1;
    else if (c <= 0 && ep >= 0 && eq <= 0) demi_near_segment(p, q, part);
    else if (b <= 0 && fp >= 0 && fr <= 0) {
        demi_near_segment(p, r, part);
        part[2] = part[1];
        part[1] = 0;
    } else if (a <= 0 && fq >= eq && er >= fr) demi_near_segment(q, r, part + 1);
    else {
        part[0] = a/(a + b + c);
        part[1] = b/(a + b + c);
        part[2] = c/(a + b + c);
    }
}
/* The point of a simplex nearest to the origin, which corners without part in it leave; how far off
   it is, squared. All four stay where the origin is inside. */
static double demi_simplex_near(demi_simplex *s, double *v) {
    static const int sides[4][4] = {{0, 1, 2, 3}, {0, 3, 1, 2}, {1, 3, 2, 0}, {0, 2, 3, 1}};
    double part[4] = {1, 0, 0, 0}, tried[3], x[3];
    double least = 1e300;
    int i, k, left = 0;
    if (s->count == 2) demi_near_segment(s->at[0].x, s->at[1].x, part);
    else if (s->count == 3)
        demi_near_triangle(s->at[0].x, s->at[1].x, s->at[2].x, part);
    for (i = 0; i < 4 && s->count == 4; i++) {
        const double *p = s->at[sides[i][0]].x, *q = s->at[sides[i][1]].x;
        const double *r = s->at[sides[i][2]].x;
        double e[3], f[3], n[3], d[3], high;
        demi_sub3(q, p, e);
        demi_sub3(r, p, f);
        demi_cross3(e, f, n);
        demi_sub3(s->at[sides[i][3]].x, p, d);
        high = demi_dot3(n, d);
        if (high*high > 1e-20*demi_dot3(n, n)*demi_dot3(d, d) &&       /* not flat */
            -demi_dot3(n, p)*high > 0) continue;        /* on the fourth one's side */
        demi_near_triangle(p, q, r, tried);
        for (k = 0; k < 3; k++) x[k] = tried[0]*p[k] + tried[1]*q[k] + tried[2]*r[k];
        if (!(demi_dot3(x, x) < least)) continue;
        least = demi_dot3(x, x);
        part[sides[i][3]] = 0;
        for (k = 0; k < 3; k++) part[sides[i][k]] = tried[k];
    }
    if (s->count == 4 && least > 1e299) return 0;
    v[0] = v[1] = v[2] = 0;
    for (i = 0; i < s->count; i++) {
        if (!(part[i] > 0)) continue;
        for (k = 0; k < 3; k++) v[k] += part[i]*s->at[i].x[k];
        s->at[left] = s->at[i];
        s->part[left++] = part[i];
    }
    s->count = left;
    return demi_dot3(v, v);
}
/* The normal of a simplex's triangle where it has three corners, to the side of v; else v itself,
   unit. */
static void demi_simplex_normal(const demi_simplex *s, const double *v, double *n) {
    double e[3], f[3], side;
    int k;
    memcpy(n, v, 3*sizeof *n);
    if (s->count == 3) {
        demi_sub3(s->at[1].x, s->at[0].x, e);
        demi_sub3(s->at[2].x, s->at[0].x, f);
        demi_cross3(e, f, n);
        side = demi_dot3(n, v);
        for (k = 0; k < 3; k++) n[k] = side < 0 ? -n[k] : n[k];
    }
    demi_unit3(n);
}
static int demi_lead_known(const demi_lead *at, int count, const demi_lead *w) {
    int i;
    for (i = 0; i < count; i++) if (at[i].a == w->a && at[i].b == w->b) return 1;
    return 0;
}
/* Are the two apart, by more than tiny, m? n: where to begin, then from a to b, unit. */
static int demi_solids_apart(const demi_solid *a, const demi_solid *b, double tiny, double *n,
                             demi_simplex *s) {
    double v[3], had_v[3], far = 1e300;
    demi_simplex had;
    int turn, k;
    memcpy(v, n, sizeof v);
    if (!(demi_dot3(v, v) > 0)) demi_sub3(b->centre, a->centre, v);
    if (!(demi_dot3(v, v) > 0)) v[2] = 1;
    s->count = 0;
    for (turn = 0; turn < 100; turn++) {
        const double back[3] = {-v[0], -v[1], -v[2]};
        double now;
        demi_lead *w = &s->at[s->count];
        demi_lead_along(a, b, back, w);
        if (turn && (far - demi_dot3(v, w->x) <= 1e-14*far ||
                     demi_lead_known(s->at, s->count, w))) break;
        had = *s;
        memcpy(had_v, v, sizeof v);
        s->count++;
        now = demi_simplex_near(s, v);
        if (!(now > tiny*tiny)) return 0;
        if (!(now < far)) {                     /* rounding: no nearer */
            *s = had;
            memcpy(v, had_v, sizeof v);
            break;
        }
        far = now;
    }
    demi_simplex_normal(s, v, n);
    for (k = 0; k < 3; k++) if (!(n[k] >= -1 && n[k] <= 1)) return 0;
    return 1;
}

/* --- overlapping: a polytope that grows about the origin --- */

enum { DEMI_POLYTOPE = 120 };
typedef struct demi_polytope {
    int corners, faces;
    double size;                   /* m, of both bodies: round-off of corners goes by it */
    demi_lead at[DEMI_POLYTOPE];
    struct {
        double n[3], at;           /* n unit, outward; n.x */
        double blur;               /* error of n, rad: large where the face is thin or small */
        int corner[3];
    } face[2*DEMI_POLYTOPE];
} demi_polytope;
/* A face; one without an area is never the nearest, and seen from nowhere. */
static void demi_polytope_face(demi_polytope *p, int i, int a, int b, int c) {
    double e[3], f[3], g[3], *n = p->face[i].n, sides, area;
    demi_sub3(p->at[b].x, p->at[a].x, e);
    demi_sub3(p->at[c].x, p->at[a].x, f);
    demi_cross3(e, f, n);
    p->face[i].corner[0] = a; p->face[i].corner[1] = b; p->face[i].corner[2] = c;
    p->face[i].blur = 0;
    sides = demi_dot3(e, e)*demi_dot3(f, f);
    area = demi_unit3(n);
    if (area > 1e-15*sqrt(sides)) {
        demi_sub3(f, e, g);
        sides = DEMI_MAX(demi_dot3(e, e), DEMI_MAX(demi_dot3(f, f), demi_dot3(g, g)));
        p->face[i].at = demi_dot3(n, p->at[a].x);
        p->face[i].blur = 1e-15*p->size*sqrt(sides)/area;       /* over the least height */
    } else {
        n[0] = n[1] = n[2] = 0;
        p->face[i].at = 1e300;
    }
}
/* How far x is from the point, the line or the plane of the first corners. */
static double demi_polytope_off(const demi_polytope *p, const double *x) {
    double d[3], e[3], f[3], n[3];
    demi_sub3(x, p->at[0].x, d);
    if (p->corners == 1) return sqrt(demi_dot3(d, d));
    demi_sub3(p->at[1].x, p->at[0].x, e);
    demi_cross3(e, d, n);
    if (p->corners == 2) return sqrt(demi_dot3(n, n)/demi_dot3(e, e));
    demi_sub3(p->at[2].x, p->at[0].x, f);
    demi_cross3(e, f, n);
    demi_unit3(n);
    return fabs(demi_dot3(n, d));
}
/* The first tetrahedron, from the simplex at which the walk has ended. 0: D is flat. */
static int demi_polytope_begin(const demi_solid *a, const demi_solid *b, const demi_simplex *s,
                               double size, demi_polytope *p) {
    static const int sides[4][4] = {{0, 1, 2, 3}, {0, 3, 1, 2}, {1, 3, 2, 0}, {0, 2, 3, 1}};
    int i, k;
    p->corners = s->count;
    p->size = size;
    for (i = 0; i < s->count; i++) p->at[i] = s->at[i];
    if (p->corners == 4) {                      /* it may be flat */
        p->corners = 3;
        if (demi_polytope_off(p, p->at[3].x) > 1e-9*size) p->corners = 4;
    }
    while (p->corners < 4) {
        double e[3] = {0, 0, 0}, f[3] = {0, 0, 0}, most = 0;
        demi_lead best, w;
        memset(&best, 0, sizeof best);
        if (p->corners > 1) demi_sub3(p->at[1].x, p->at[0].x, e);
        if (p->corners > 2) demi_sub3(p->at[2].x, p->at[0].x, f);
        for (i = 0; i < 6; i++) {
            double way[3] = {0, 0, 0}, off;
            way[i/2] = i & 1 ? -1 : 1;
            if (p->corners == 2) demi_cross3(e, way, way);
            if (p->corners == 3) {
                demi_cross3(e, f, way);
                for (k = 0; k < 3 && i & 1; k++) way[k] = -way[k];
            }
            demi_lead_along(a, b, way, &w);
            off = demi_polytope_off(p, w.x);
            if (off > most) { most = off; best = w; }
        }
        if (!(most > 1e-13*size)) return 0;
        p->at[p->corners++] = best;
    }
    for (i = 0; i < 4; i++) {
        const int *c = sides[i];
        demi_polytope_face(p, i, c[0], c[1], c[2]);
        if (demi_dot3(p->face[i].n, p->at[c[3]].x) > p->face[i].at)
            demi_polytope_face(p, i, c[0], c[2], c[1]);
    }
    p->faces = 4;
    return 1;
}
/* m: how far a corner is over the plane of face i beyond what round-off may put it there. Of faces
   that are coplanar with it some would see it otherwise and some not, and what joins it to their
   rim would be folded. most: of that, m. */
static double demi_polytope_over(const demi_polytope *p, int i, const demi_lead *w, double most) {
    double d[3];
    demi_sub3(w->x, p->at[p->face[i].corner[0]].x, d);
    return demi_dot3(p->face[i].n, d) - DEMI_MIN(p->face[i].blur*sqrt(demi_dot3(d, d)), most);
}
/* Takes a corner in: faces that see it, the nearest at least, give way to those that join it to
   their rim. 0: no room. */
static int demi_polytope_take(demi_polytope *p, int nearest, const demi_lead *w) {
    int rim[2*DEMI_POLYTOPE][2], count = 0, left = 0, i, k, e;
    unsigned char seen[2*DEMI_POLYTOPE];
    if (p->corners == DEMI_POLYTOPE) return 0;
    for (i = 0; i < p->faces; i++) {
        seen[i] = i == nearest || demi_polytope_over(p, i, w, 1e300) > 1e-14*p->size;
        if (!seen[i]) { left++; continue; }
        for (k = 0; k < 3; k++) {               /* sides that two of them have go */
            const int from = p->face[i].corner[k], to = p->face[i].corner[(k + 1)%3];
            for (e = 0; e < count && !(rim[e][0] == to && rim[e][1] == from); e++) continue;
            if (e < count) { count--; rim[e][0] = rim[count][0]; rim[e][1] = rim[count][1]; }
            else if (count < 2*DEMI_POLYTOPE) { rim[count][0] = from; rim[count++][1] = to; }
        }
    }
    if (!count || left + count > 2*DEMI_POLYTOPE) return 0;
    for (i = 0, left = 0; i < p->faces; i++)
        if (!seen[i]) p->face[left++] = p->face[i];
    p->at[p->corners] = *w;
    for (e = 0; e < count; e++) demi_polytope_face(p, left + e, rim[e][0], rim[e][1], p->corners);
    p->corners++;
    p->faces = left + count;
    return 1;
}
/* The least way that parts two that overlap: n, from a to b. What ends it early (rounding, no room)
   leaves the least one seen, which parts them, too. */
static void demi_solids_part(const demi_solid *a, const demi_solid *b, double size, double *n,
                             demi_simplex *s) {
    demi_polytope p;
    demi_lead w;
    double least = 1e300;
    int i, k, best;
    if (!demi_polytope_begin(a, b, s, size, &p)) {
        if (!(demi_dot3(n, n) > 0)) n[2] = 1;
        demi_unit3(n);
        return;
    }
    do {
        double way;
        for (i = 1, best = 0; i < p.faces; i++)
            if (p.face[i].at < p.face[best].at) best = i;
        demi_lead_along(a, b, p.face[best].n, &w);
        way = demi_dot3(p.face[best].n, w.x);
        for (k = 0; k < 3 && way < least; k++) {
            s->at[k] = p.at[p.face[best].corner[k]];
            n[k] = -p.face[best].n[k];
        }
        least = DEMI_MIN(least, way);
    } while (demi_polytope_over(&p, best, &w, 1e-9*size) > 1e-13*size &&
             !demi_lead_known(p.at, p.corners, &w) && demi_polytope_take(&p, best, &w));
    s->count = 3;
    demi_near_triangle(s->at[0].x, s->at[1].x, s->at[2].x, s->part);
}
/* Width of the slab across n that keeps them apart, m; < 0: by how much none does. */
static double demi_solids_slab(const demi_solid *a, const demi_solid *b, const double *n) {
    const double back[3] = {-n[0], -n[1], -n[2]};
    double x[3];
    demi_sub3(b->corner[demi_solid_far(b, back)], a->corner[demi_solid_far(a, n)], x);
    return demi_dot3(n, x);
}
/* How far the two are apart, m, < 0: how deep in each other; n: in: where to begin, or 0; out:
   unit, from a to b. s: corners that tell it. */
static double demi_solids_gap(const demi_solid *a, const demi_solid *b, double *n,
                              demi_simplex *s) {
    double x[3], size = 0, least = 1e300, gap;
    const demi_solid *bodies[2];
    int i, k;
    bodies[0] = a; bodies[1] = b;
    for (i = 0; i < 2; i++) {
        double most = 0;
        for (k = 0; k < bodies[i]->corners; k++) {
            demi_sub3(bodies[i]->corner[k], bodies[i]->centre, x);
            most = DEMI_MAX(most, demi_dot3(x, x));
        }
        size += sqrt(most);
        least = DEMI_MIN(least, sqrt(most));
    }
    if (demi_solids_apart(a, b, DEMI_MAX(1e-7*least, 1e-14*size), n, s)) {
        gap = demi_solids_slab(a, b, n);
        if (gap > 0) return gap;
    }
    demi_solids_part(a, b, size, n, s);
    return demi_solids_slab(a, b, n);
}

/* --- the points by which two keep each other off --- */

/* No more than four: x in the middle between both surfaces, gaps along the normal. */
typedef struct demi_spots {
    int count;
    double normal[3];              /* unit, from a to b */
    double x[4][3], gap[4];        /* m */
} demi_spots;
/* Of many points across n those that keep most: the deepest, the farthest from it, and on either
   side of the line through both the farthest from that. */
static int demi_spots_pick(double (*x)[3], const double *gap, int count, const double *n,
                           int *out) {
    double d[3], e[3], f[3], most = -1, side[2] = {0, 0};
    int i, k, picked = 1, far[2] = {-1, -1};
    if (count <= 4) {
        for (i = 0; i < count; i++) out[i] = i;
        return count;
    }
    out[0] = out[1] = 0;
    for (i = 1; i < count; i++) if (gap[i] < gap[out[0]]) out[0] = i;
    for (i = 0; i < count; i++) {
        demi_sub3(x[i], x[out[0]], d);
        if (demi_dot3(d, d) > most) { most = demi_dot3(d, d); out[1] = i; }
    }
    if (!(most > 0)) return 1;
    picked = 2;
    demi_sub3(x[out[1]], x[out[0]], e);
    demi_cross3(n, e, f);
    for (i = 0; i < count; i++) {
        double off;
        demi_sub3(x[i], x[out[0]], d);
        off = demi_dot3(f, d);
        k = off < 0;
        if (fabs(off) > side[k] + 1e-9*most) { side[k] = fabs(off); far[k] = i; }
    }
    for (k = 0; k < 2; k++) if (far[k] >= 0) out[picked++] = far[k];
    return picked;
}
/* The face whose normal is most along n; by how much. */
static int demi_solid_facing(const demi_solid *s, const double *n, double *along) {
    int f, best = -1;
    *along = -2;
    for (f = 0; f < s->faces; f++) {
        const double c = demi_dot3(s->plane[f], n)*s->plane[f][3];
        if (c > *along) { *along = c; best = f; }
    }
    return best;
}
/* Faces that are square to a normal up to 1.8 degrees. */
#define DEMI_FLUSH 0.9995
/* Of body b's face that faces face f of a most, what lies over f: points, and gaps over its plane.
   */
static int demi_faces_over(const demi_solid *a, int f, const demi_solid *b, double (*x)[3],
                           double *gap, double *n) {
    const int32_t *loop = a->rim + a->faces + 1 + a->rim[f];
    const int sides = a->rim[f + 1] - a->rim[f];
    const int32_t *other;
    double along, back[3], d[3];
    int g, i, k, count = 0;
    for (k = 0; k < 3; k++) {
        n[k] = a->plane[f][k]*a->plane[f][3];
        back[k] = -n[k];
    }
    g = demi_solid_facing(b, back, &along);
    if (g < 0) return 0;
    other = b->rim + b->faces + 1;
    for (i = b->rim[g]; i < b->rim[g + 1]; i++)
        memcpy(x[count++], b->corner[other[i]], sizeof *x);
    for (i = 0; i < sides && count; i++) {
        double e[3], in[3];
        demi_sub3(a->corner[loop[i + 1 < sides ? i + 1 : 0]], a->corner[loop[i]], e);
        demi_cross3(n, e, in);
        count = demi_polygon_clip(x, count, in, a->corner[loop[i]]);
    }
    for (i = 0; i < count; i++) {
        demi_sub3(x[i], a->corner[loop[0]], d);
        gap[i] = demi_dot3(n, d);
        for (k = 0; k < 3; k++) x[i][k] -= gap[i]*n[k]/2;
    }
    return count;
}
/* The contact of two that are no farther apart than range: 0: they are. facet: b is flat, and its
   plane comes first. guess: normal of a step ago, or 0. s: corners that told the gap. */
static int demi_solids_spots(const demi_solid *a, const demi_solid *b, int facet, double range,
                             const double *guess, demi_simplex *s, demi_spots *out) {
    double x[DEMI_SECTION][3], gap[DEMI_SECTION], n[3], back[3], on_a, on_b, all, to_b[3];
    int fa, fb, i, k, second, count = 0, left, picked[4];
    memcpy(n, guess, sizeof n);
    out->count = 0;
    all = demi_solids_gap(a, b, n, s);
    if (!(all < range)) return 0;
    for (k = 0; k < 3; k++) back[k] = -n[k];
    fa = demi_solid_facing(a, n, &on_a);
    fb = demi_solid_facing(b, back, &on_b);
    second = on_b >= DEMI_FLUSH && (facet || on_b > on_a + 1e-9);
    if (second) {
        count = demi_faces_over(b, fb, a, x, gap, back);
        for (k = 0; k < 3; k++) to_b[k] = -back[k];
    } else if (on_a >= DEMI_FLUSH) count = demi_faces_over(a, fa, b, x, gap, to_b);
    for (i = 0, left = 0; i < count; i++) {
        if (!(gap[i] < range)) continue;
        memmove(x[left], x[i], sizeof *x);
        gap[left++] = gap[i];
    }
    memcpy(out->normal, left ? to_b : n, sizeof n);
    if (!left) {                                /* corners, edges */
        for (k = 0; k < 3; k++)
            for (i = 0, x[0][k] = 0; i < s->count; i++)
                x[0][k] += s->part[i]*(a->corner[s->at[i].a][k] + b->corner[s->at[i].b][k])/2;
        gap[0] = all;
        left = 1;
    }
    out->count = demi_spots_pick(x, gap, left, out->normal, picked);
    for (i = 0; i < out->count; i++) {
        memcpy(out->x[i], x[picked[i]], sizeof *x);
        out->gap[i] = gap[picked[i]];
    }
    return out->count;
}
