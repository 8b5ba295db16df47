/* convex.h - contact of two convex polyhedra, worked out in ways of its own: oracles for tests. Needs no dem.h.

   convex_brute   the signed gap by brute force: the distance over all pairs of features, or minus the depth, the least
                  over all directions that can be least (separating axis theorem); no tolerance in it.
   convex_mpr     touching or not, and an upper bound of the depth, by Minkowski portal refinement ("XenoCollide",
                  Snethen, Game Programming Gems 7, 2008).
   convex_pair    draws a pair for tests: six kinds of shape, seven kinds of meeting, from 1e-5 to 10 m.

   The normal points from a to b: b moved along it comes away from a. Coordinates are metres or anything else: there is
   no absolute length in here, and all answers for bodies scaled by a power of two are the same bits, scaled. A body is
   best placed within some of its sizes of the origin; coordinates are rounded there. C99 that is also C++11, no
   allocation, no globals. */
#ifndef CONVEX_H
#define CONVEX_H
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

/* A convex polyhedron as the oracles see it. Its corners say what it is; its planes are right to round-off. */
typedef struct convex_body {
    int corners, faces, edges;
    const double *corner;       /* (corners x 3) */
    const double *plane;        /* (faces x 4): unit normal n outwards, and d: n.x <= d inside */
    const int *edge;            /* (edges x 2): pairs of corners */
} convex_body;

/* One with room of its own. */
enum { CONVEX_CORNERS = 64, CONVEX_FACES = 128, CONVEX_EDGES = 192 };
typedef struct convex_solid {
    int corners, faces, edges;
    double corner[3*CONVEX_CORNERS], plane[4*CONVEX_FACES];
    int edge[2*CONVEX_EDGES];
} convex_solid;

/* What brute force says: b - a = gap*normal. */
typedef struct convex_gap {
    double gap;                 /* > 0: distance; < 0: minus the depth, the shortest way that parts the two */
    double slab;                /* width of the slab between them square to the normal: the gap again, which it proves */
    double normal[3], a[3], b[3];  /* unit, from a to b; the nearest points, of overlapping bodies the deepest */
} convex_gap;

/* What portals say. */
typedef struct convex_verdict {
    int touching, sure;         /* sure 0: no start came to an end; the verdict is that of the best direction seen */
    double depth, normal[3];    /* the way along normal that parts them; of two apart < 0, minus a width between them */
    int starts, steps;          /* interior points tried, support points asked for */
} convex_verdict;

/* ---- vectors ---- */
typedef long double convex_fine;
static inline double convex_dot(const double *a, const double *b) { return a[0]*b[0] + a[1]*b[1] + a[2]*b[2]; }
static inline void convex_cross(const double *a, const double *b, double *c) {
    const double x = a[1]*b[2] - a[2]*b[1], y = a[2]*b[0] - a[0]*b[2];
    c[2] = a[0]*b[1] - a[1]*b[0];
    c[0] = x;
    c[1] = y;
}
static inline void convex_minus(const double *a, const double *b, double *c) {
    int k;
    for (k = 0; k < 3; k++) c[k] = a[k] - b[k];
}
/* Makes it of length one, and returns the length it had; one without length stays as it is. */
static inline double convex_unit(double *a) {
    const double length = sqrt(convex_dot(a, a));
    int k;
    for (k = 0; k < 3 && length > 0; k++) a[k] /= length;
    return length;
}
static inline convex_fine convex_fine_dot(const convex_fine *a, const convex_fine *b) {
    return a[0]*b[0] + a[1]*b[1] + a[2]*b[2];
}
static inline void convex_fine_cross(const convex_fine *a, const convex_fine *b, convex_fine *c) {
    c[0] = a[1]*b[2] - a[2]*b[1];
    c[1] = a[2]*b[0] - a[0]*b[2];
    c[2] = a[0]*b[1] - a[1]*b[0];
}
static inline void convex_fine_minus(const convex_fine *a, const convex_fine *b, convex_fine *c) {
    int k;
    for (k = 0; k < 3; k++) c[k] = a[k] - b[k];
}
/* Corner i of a body, seen from o: differences of doubles, exact or nearly so. */
static inline void convex_fine_corner(const convex_body *s, int i, const double *o, convex_fine *x) {
    int k;
    for (k = 0; k < 3; k++) x[k] = (convex_fine)s->corner[3*i + k] - (convex_fine)o[k];
}

/* ---- brute force ---- */
/* The slab square to n, of any sign, that parts the two: its width, < 0 when they overlap along n. No more than `least`:
   the corners that were not looked at cannot better it. */
static inline convex_fine convex_slab(const convex_body *a, const convex_body *b, const double *o, const convex_fine *n,
                                      convex_fine least, int *backwards) {
    convex_fine lo[2] = {0, 0}, hi[2] = {0, 0}, width = 0, x[3];
    int i, k;
    for (i = 0; i < a->corners || i < b->corners; i++) {
        for (k = 0; k < 2; k++) {
            const convex_body *s = k ? b : a;
            if (i >= s->corners) continue;
            convex_fine_corner(s, i, o, x);
            x[0] = convex_fine_dot(n, x);
            if (i == 0 || x[0] < lo[k]) lo[k] = x[0];
            if (i == 0 || x[0] > hi[k]) hi[k] = x[0];
        }
        *backwards = lo[0] - hi[1] > lo[1] - hi[0];
        width = *backwards ? lo[0] - hi[1] : lo[1] - hi[0];
        if (width <= least) return width;
    }
    return width;
}
typedef struct convex_widest { convex_fine apart, normal[3]; } convex_widest;
static inline void convex_try_slab(const convex_body *a, const convex_body *b, const convex_fine *n, convex_widest *w) {
    int backwards = 0, k;
    const convex_fine apart = convex_slab(a, b, a->corner, n, w->apart, &backwards);
    if (apart <= w->apart) return;
    w->apart = apart;
    for (k = 0; k < 3; k++) w->normal[k] = backwards ? -n[k] : n[k];
}
static inline void convex_try_faces(const convex_body *a, const convex_body *b, const convex_body *of, convex_widest *w) {
    int f, k;
    for (f = 0; f < of->faces; f++) {
        convex_fine n[3], length;
        for (k = 0; k < 3; k++) n[k] = (convex_fine)of->plane[4*f + k];
        length = sqrtl(convex_fine_dot(n, n));
        for (k = 0; k < 3; k++) n[k] /= length;
        convex_try_slab(a, b, n, w);
    }
}
/* The unit vector square to two edges, 0 where they are parallel to the last digit. Of edges that are nearly parallel
   it has an error of round-off over their angle; the share of it along an edge would count with the edge's length
   and is taken out, the share across counts with the angle and does not matter. */
static inline int convex_across(const convex_fine *u, const convex_fine *v, convex_fine *n) {
    const convex_fine uu = convex_fine_dot(u, u), vv = convex_fine_dot(v, v);
    const convex_fine *longer = uu > vv ? u : v;
    convex_fine length, along;
    int k;
    convex_fine_cross(u, v, n);
    length = sqrtl(convex_fine_dot(n, n));
    if (!(length > 4*LDBL_EPSILON*sqrtl(uu*vv))) return 0;
    for (k = 0; k < 3; k++) n[k] /= length;
    along = convex_fine_dot(n, longer)/(uu > vv ? uu : vv);
    for (k = 0; k < 3; k++) n[k] -= along*longer[k];
    length = sqrtl(convex_fine_dot(n, n));
    for (k = 0; k < 3; k++) n[k] /= length;
    return length > 0.5L;
}
static inline void convex_edge(const convex_body *s, int e, const double *o, convex_fine *x, convex_fine *u) {
    convex_fine_corner(s, s->edge[2*e], o, x);
    convex_fine_corner(s, s->edge[2*e + 1], o, u);
    convex_fine_minus(u, x, u);
}
/* The widest slab that parts them, or the one along which they overlap least: its normal is that of a face of one of
   them or square to an edge of each. */
static inline convex_widest convex_widest_of(const convex_body *a, const convex_body *b) {
    convex_widest w;
    convex_fine x[3], u[3], v[3], n[3];
    int i, j;
    w.apart = -LDBL_MAX;
    w.normal[0] = w.normal[1] = 0;
    w.normal[2] = 1;
    convex_try_faces(a, b, a, &w);
    convex_try_faces(a, b, b, &w);
    for (i = 0; i < a->edges; i++) {
        convex_edge(a, i, a->corner, x, u);
        for (j = 0; j < b->edges; j++) {
            convex_edge(b, j, a->corner, x, v);
            if (convex_across(u, v, n)) convex_try_slab(a, b, n, &w);
        }
    }
    return w;
}

/* The nearest two points found so far, of a and of b moved by `shift`, seen from o. */
typedef struct convex_nearest {
    const double *o;
    convex_fine shift[3], square, x[2][3];
} convex_nearest;
static inline void convex_corner_of(const convex_nearest *m, const convex_body *s, int which, int i, convex_fine *x) {
    int k;
    convex_fine_corner(s, i, m->o, x);
    for (k = 0; k < 3 && which; k++) x[k] += m->shift[k];
}
static inline void convex_try_points(convex_nearest *m, const convex_fine *x, const convex_fine *y, int which) {
    convex_fine d[3], square;
    convex_fine_minus(x, y, d);
    square = convex_fine_dot(d, d);
    if (!(square < m->square)) return;
    m->square = square;
    memcpy(m->x[which], x, sizeof m->x[which]);
    memcpy(m->x[!which], y, sizeof m->x[!which]);
}
/* Point x of body `which` and the segment from y along v. */
static inline void convex_try_segment(convex_nearest *m, const convex_fine *x, int which, const convex_fine *y,
                                      const convex_fine *v) {
    convex_fine w[3], t;
    int k;
    convex_fine_minus(x, y, w);
    t = convex_fine_dot(w, v)/convex_fine_dot(v, v);
    t = t > 0 ? t < 1 ? t : 1 : 0;
    for (k = 0; k < 3; k++) w[k] = y[k] + t*v[k];
    convex_try_points(m, x, w, which);
}
/* All corners of body `which` against all edges of the other, their ends included. */
static inline void convex_try_corners(convex_nearest *m, const convex_body *s, const convex_body *other, int which) {
    convex_fine x[3], y[3], v[3];
    int i, e;
    for (e = 0; e < other->edges; e++) {
        convex_corner_of(m, other, !which, other->edge[2*e], y);
        convex_corner_of(m, other, !which, other->edge[2*e + 1], v);
        convex_fine_minus(v, y, v);
        for (i = 0; i < s->corners; i++) {
            convex_corner_of(m, s, which, i, x);
            convex_try_segment(m, x, which, y, v);
        }
    }
}
/* Is x, on the plane of face f, within the face? Else an edge is nearer. */
static inline int convex_within(const convex_nearest *m, const convex_body *s, int which, int f, const convex_fine *x) {
    int g, k;
    for (g = 0; g < s->faces; g++) {
        convex_fine height = -(convex_fine)s->plane[4*g + 3];
        if (g == f) continue;
        for (k = 0; k < 3; k++) {
            const convex_fine at_k = x[k] + (convex_fine)m->o[k] - (which ? m->shift[k] : 0);
            height += (convex_fine)s->plane[4*g + k]*at_k;
        }
        if (height > 0) return 0;
    }
    return 1;
}
/* All corners of body `which` over all faces of the other, or under them: of bodies that just touch round-off puts corners
   there, and any point of one and point of the other bound the distance. */
static inline void convex_try_feet(convex_nearest *m, const convex_body *s, const convex_body *other, int which) {
    int f, i, k;
    for (f = 0; f < other->faces; f++) {
        convex_fine n[3], x[3], top = -LDBL_MAX, square;
        for (k = 0; k < 3; k++) n[k] = (convex_fine)other->plane[4*f + k];
        square = convex_fine_dot(n, n);
        for (i = 0; i < other->corners; i++) {
            convex_corner_of(m, other, !which, i, x);
            top = fmaxl(top, convex_fine_dot(n, x));
        }
        for (i = 0; i < s->corners; i++) {
            convex_fine foot[3], height;
            convex_corner_of(m, s, which, i, x);
            height = convex_fine_dot(n, x) - top;
            if (height*height >= m->square*square) continue;
            for (k = 0; k < 3; k++) foot[k] = x[k] - height/square*n[k];
            if (convex_within(m, other, !which, f, foot)) convex_try_points(m, x, foot, which);
        }
    }
}
/* All pairs of edges where both nearest points lie between the ends. With n = u x v and w = y - x:
   s = (w x v).n/n.n on a; what round-off over the angle does to s of nearly parallel edges, the angle undoes. */
static inline void convex_try_edges(convex_nearest *m, const convex_body *a, const convex_body *b) {
    convex_fine x[3], y[3], u[3], v[3], w[3], n[3], c[3], square, s;
    int i, j, k;
    for (i = 0; i < a->edges; i++) {
        convex_edge(a, i, m->o, x, u);
        for (j = 0; j < b->edges; j++) {
            convex_edge(b, j, m->o, y, v);
            for (k = 0; k < 3; k++) y[k] += m->shift[k];
            convex_fine_minus(y, x, w);
            convex_fine_cross(u, v, n);
            square = convex_fine_dot(n, n);
            s = convex_fine_dot(w, n);
            if (!(square > 0) || s*s >= m->square*square) continue;
            convex_fine_cross(w, v, c);
            s = convex_fine_dot(c, n)/square;
            if (!(s > 0 && s < 1)) continue;
            for (k = 0; k < 3; k++) c[k] = x[k] + s*u[k];
            convex_try_segment(m, c, 0, y, v);
            for (k = 0; k < 3; k++) c[k] = m->x[1][k];
            convex_try_segment(m, c, 1, x, u);
        }
    }
}
static inline void convex_nearest_of(convex_nearest *m, const convex_body *a, const convex_body *b) {
    m->o = a->corner;
    m->square = LDBL_MAX;
    convex_try_corners(m, a, b, 0);
    convex_try_corners(m, b, a, 1);
    convex_try_feet(m, a, b, 0);
    convex_try_feet(m, b, a, 1);
    convex_try_edges(m, a, b);
}
/* Slabs square to the way between the nearest points. That of two that nearly touch is round-off to a good part, so it is
   also made square to each edge in turn: one of them is the edge that it must be square to, if there is one. */
static inline void convex_try_way(const convex_nearest *m, const convex_body *a, const convex_body *b, convex_widest *w) {
    convex_fine x[3], u[3], way[3], n[3], length;
    int e, k;
    convex_fine_minus(m->x[1], m->x[0], way);
    for (e = -1; e < a->edges + b->edges; e++) {
        convex_fine off = 0;
        if (e >= 0) {
            convex_edge(e < a->edges ? a : b, e < a->edges ? e : e - a->edges, m->o, x, u);
            off = convex_fine_dot(way, u)/convex_fine_dot(u, u);
        }
        for (k = 0; k < 3; k++) n[k] = e < 0 ? way[k] : way[k] - off*u[k];
        length = sqrtl(convex_fine_dot(n, n));
        for (k = 0; k < 3 && length > 0; k++) n[k] /= length;
        if (length > 0) convex_try_slab(a, b, n, w);
    }
}
/* The signed gap. Its error is round-off: some 1e-16 of the larger body, by the planes handed over; what does not hang
   on them is as good as long double. The deepest points are those that meet when b has been moved out. The normal of two
   apart is that of the slab or the way between the nearest points, whichever makes the wider slab: of two that nearly
   touch the way is mostly round-off. */
static inline convex_gap convex_brute(const convex_body *a, const convex_body *b) {
    convex_widest w = convex_widest_of(a, b);
    convex_fine gap = w.apart;
    convex_nearest m;
    convex_gap g;
    int k;
    for (k = 0; k < 3; k++) m.shift[k] = w.apart < 0 ? -w.apart*w.normal[k] : 0;
    convex_nearest_of(&m, a, b);
    if (w.apart > 0 && m.square > w.apart*w.apart) {
        gap = sqrtl(m.square);
        convex_try_way(&m, a, b, &w);
    }
    for (k = 0; k < 3; k++) {
        g.normal[k] = (double)w.normal[k];
        g.a[k] = (double)((convex_fine)m.o[k] + m.x[0][k]);
        g.b[k] = (double)((convex_fine)m.o[k] + m.x[1][k] - m.shift[k]);
    }
    g.gap = (double)gap;
    g.slab = (double)w.apart;
    return g;
}

/* ---- Minkowski portal refinement ---- */
/* The set of all differences x - y, x of a, y of b, is convex, and holds the origin when and only when the two touch. A
   ray from v[0] inside of it to the origin leaves it through the portal, a triangle of points v[1..3] of its surface,
   which is moved outwards to the surface. */
typedef struct convex_portal {
    const convex_body *a, *b;
    double v[5][3], size;       /* v[4]: the last support point; size: of both bodies together */
    double least, best[3];      /* the least support of all unit vectors asked for, and its vector */
    int steps;
} convex_portal;
enum { CONVEX_LOST, CONVEX_APART, CONVEX_TOUCHING };

static inline const double *convex_support(const convex_body *s, const double *n, double sign) {
    double most = -DBL_MAX;
    int i, at = 0;
    for (i = 0; i < s->corners; i++) {
        double x[3], height;
        convex_minus(s->corner + 3*i, s->corner, x);  /* from a corner: a body far from the origin loses nothing */
        height = sign*convex_dot(n, x);
        if (height > most) { most = height; at = i; }
    }
    return s->corner + 3*at;
}
/* Into v[4] the point of the set that is farthest along n; returns how far along n, for n of length one. Below zero n
   parts the two, whatever way n was come by. */
static inline double convex_far(convex_portal *p, const double *n) {
    double reach;
    convex_minus(convex_support(p->a, n, 1), convex_support(p->b, n, -1), p->v[4]);
    p->steps++;
    reach = convex_dot(n, p->v[4]);
    if (reach < p->least) {
        p->least = reach;
        memcpy(p->best, n, sizeof p->best);
    }
    return reach;
}
/* Unit vector square to two that start at v[0] (from = 0) or v[1]. 0: they are too nearly parallel to tell. */
static inline int convex_square_to(const convex_portal *p, int from, int i, int j, double *n) {
    double u[3], w[3], area;
    convex_minus(p->v[i], p->v[from], u);
    convex_minus(p->v[j], p->v[from], w);
    convex_cross(u, w, n);
    area = sqrt(convex_dot(u, u)*convex_dot(w, w));
    return convex_unit(n) > 1e-13*area;
}
/* On which side of the plane of the ray and v[i] is v[j]? The volume of v0, vi, vj and the origin, times 6. */
static inline double convex_side(const convex_portal *p, int i, int j) {
    double c[3];
    convex_cross(p->v[i], p->v[j], c);
    return convex_dot(c, p->v[0]);
}
static inline void convex_put(convex_portal *p, int to, int from) { memcpy(p->v[to], p->v[from], sizeof p->v[to]); }
static inline void convex_swap(convex_portal *p, int i, int j) {
    double x[3];
    memcpy(x, p->v[i], sizeof x);
    convex_put(p, i, j);
    memcpy(p->v[j], x, sizeof x);
}
/* Finds a portal; CONVEX_TOUCHING means only that there is one. */
static inline int convex_find_portal(convex_portal *p) {
    double n[3];
    int k, tries;
    for (k = 0; k < 3; k++) n[k] = -p->v[0][k];
    convex_unit(n);
    if (convex_far(p, n) <= 0) return CONVEX_APART;
    convex_put(p, 1, 4);
    convex_cross(p->v[1], p->v[0], n);
    if (!(convex_unit(n) > 1e-13*sqrt(convex_dot(p->v[0], p->v[0])*convex_dot(p->v[1], p->v[1])))) return CONVEX_LOST;
    if (convex_far(p, n) <= 0) return CONVEX_APART;
    convex_put(p, 2, 4);
    if (!convex_square_to(p, 0, 1, 2, n)) return CONVEX_LOST;
    if (convex_dot(n, p->v[0]) > 0) {           /* the origin is to be in front of v0, v1, v2 */
        convex_swap(p, 1, 2);
        for (k = 0; k < 3; k++) n[k] = -n[k];
    }
    for (tries = 0; tries < 100; tries++) {
        if (convex_far(p, n) <= 0) return CONVEX_APART;
        convex_put(p, 3, 4);
        if (convex_side(p, 1, 3) < 0) convex_put(p, 2, 3);
        else if (convex_side(p, 3, 2) < 0) convex_put(p, 1, 3);
        else return CONVEX_TOUCHING;
        if (!convex_square_to(p, 0, 1, 2, n)) return CONVEX_LOST;
    }
    return CONVEX_LOST;
}
/* The three triangles of v[4] and an edge of the portal: the ray passes through the one of which it is inside farthest,
   which becomes the portal. Rules that look at two of the signs only go wrong where v[4] lies in the
   plane of the ray and an edge of the portal, as it does with bodies along the axes: both signs are zero then, and the
   third decides. */
static inline void convex_split_portal(convex_portal *p) {
    const double one = convex_side(p, 4, 1), two = convex_side(p, 4, 2), three = convex_side(p, 4, 3);
    const double within_12 = fmin(two, -one), within_23 = fmin(three, -two), within_31 = fmin(one, -three);
    if (within_31 > within_12 && within_31 > within_23) convex_put(p, 2, 4);
    else convex_put(p, within_12 > within_23 ? 3 : 1, 4);
}
/* Does the ray pass through the portal, but for round-off? The origin's distances from the planes of v[0] and the
   portal's edges tell. */
static inline int convex_holds_ray(const convex_portal *p) {
    int i;
    for (i = 1; i < 4; i++) {
        const int j = i%3 + 1;
        double u[3], w[3], n[3];
        convex_minus(p->v[i], p->v[0], u);
        convex_minus(p->v[j], p->v[0], w);
        convex_cross(u, w, n);
        if (convex_side(p, i, j) > 1e-13*p->size*sqrt(convex_dot(n, n))) return 0;
    }
    return 1;
}
/* Moves the portal out to the surface. Apart: n parts the two. Touching: n is the portal's normal, and depth what the
   farthest point along it says. Lost: the portal is too thin to have a normal, or holds no volume with v[0]. */
static inline int convex_refine_portal(convex_portal *p, double *n, double *depth) {
    const int most = 2*(p->a->corners + p->b->corners) + 50;
    int round, k;
    if (!convex_square_to(p, 1, 2, 3, n)) return CONVEX_LOST;
    if (convex_dot(n, p->v[1]) < convex_dot(n, p->v[0])) convex_swap(p, 2, 3);
    for (round = 0; round < most; round++) {
        double inner;
        if (!convex_square_to(p, 1, 2, 3, n)) return CONVEX_LOST;
        inner = convex_dot(n, p->v[1]);
        if (inner - convex_dot(n, p->v[0]) < 1e-13*p->size) return CONVEX_LOST;
        for (k = 2; k < 4; k++) inner = fmax(inner, convex_dot(n, p->v[k]));
        *depth = convex_far(p, n);
        if (*depth < 0) return CONVEX_APART;
        if (*depth - inner <= 1e-13*p->size) return convex_holds_ray(p) ? CONVEX_TOUCHING : CONVEX_LOST;
        convex_split_portal(p);
    }
    return CONVEX_LOST;
}
/* A point inside of a body: the mean of its corners, for start > 0 with weights that differ a little and without a rule,
   so that it stands on no axis or plane of symmetry. */
static inline void convex_inside(const convex_body *s, int start, double *x) {
    double sum[3] = {0, 0, 0}, all = 0;
    int i, k;
    for (i = 0; i < s->corners; i++) {
        const double turns = 0.6180339887498949*(i + 1)*start + 0.27*i*i, weight = 1 + 0.02*start*(turns - floor(turns));
        for (k = 0; k < 3; k++) sum[k] += weight*(s->corner[3*i + k] - s->corner[k]);
        all += weight;
    }
    for (k = 0; k < 3; k++) x[k] = s->corner[k] + sum[k]/all;
}
/* The largest distance of a corner from the centre. */
static inline double convex_radius(const convex_body *s) {
    double centre[3], x[3], most = 0;
    int i;
    convex_inside(s, 0, centre);
    for (i = 0; i < s->corners; i++) {
        convex_minus(s->corner + 3*i, centre, x);
        most = fmax(most, convex_dot(x, x));
    }
    return sqrt(most);
}
/* Touching or not, with an upper bound of the depth. All tolerances are shares of the pair's size. A start that is lost
   is followed by another: centres that coincide, a ray along an edge of the portal or through its corner, a portal
   without area, no end within the steps that convex bodies need. */
static inline convex_verdict convex_mpr(const convex_body *a, const convex_body *b) {
    enum { most = 10 };
    convex_portal p;
    convex_verdict r;
    int start, state = CONVEX_LOST;
    memset(&p, 0, sizeof p);
    memset(&r, 0, sizeof r);
    p.a = a;
    p.b = b;
    p.size = convex_radius(a) + convex_radius(b);
    p.least = DBL_MAX;
    for (start = 0; start < most && state == CONVEX_LOST; start++) {
        convex_inside(a, start, p.v[0]);
        convex_inside(b, 0, p.v[4]);
        convex_minus(p.v[0], p.v[4], p.v[0]);
        if (convex_dot(p.v[0], p.v[0]) < 1e-16*p.size*p.size) continue;
        state = convex_find_portal(&p);
        if (state == CONVEX_TOUCHING) state = convex_refine_portal(&p, r.normal, &r.depth);
    }
    r.sure = state != CONVEX_LOST;
    if (state != CONVEX_TOUCHING) {
        memcpy(r.normal, p.best, sizeof r.normal);
        r.depth = p.least;
    }
    r.touching = r.sure ? state == CONVEX_TOUCHING : p.least > 0;
    r.starts = start;
    r.steps = p.steps;
    return r;
}

/* ---- shapes ---- */
static inline convex_body convex_view(const convex_solid *s) {
    convex_body b;
    b.corners = s->corners;
    b.faces = s->faces;
    b.edges = s->edges;
    b.corner = s->corner;
    b.plane = s->plane;
    b.edge = s->edge;
    return b;
}
/* 0 <= number < 1 (xorshift64*); the state is not 0. */
static inline double convex_random(uint64_t *state) {
    *state ^= *state >> 12;
    *state ^= *state << 25;
    *state ^= *state >> 27;
    return (double)((*state*UINT64_C(2685821657736338717)) >> 11)/9007199254740992.0;
}
static inline int convex_below(uint64_t *state, int count) { return (int)(count*convex_random(state)); }
static inline double convex_top(const convex_solid *s, const double *n) {
    double top = -DBL_MAX;
    int i;
    for (i = 0; i < s->corners; i++) top = fmax(top, convex_dot(n, s->corner + 3*i));
    return top;
}
/* Bits of the corners on the plane of three, when all others are on one side, < tolerance off; else 0. n is that
   plane's normal outwards. */
static inline uint64_t convex_facet(const convex_solid *s, int i, int j, int k, double close, double *n) {
    double u[3], w[3], x[3], lo = 0, hi = 0;
    uint64_t on = 0;
    int c;
    convex_minus(s->corner + 3*j, s->corner + 3*i, u);
    convex_minus(s->corner + 3*k, s->corner + 3*i, w);
    convex_cross(u, w, n);
    if (!(convex_unit(n) > close*sqrt(convex_dot(u, u)))) return 0;
    for (c = 0; c < s->corners; c++) {
        convex_minus(s->corner + 3*c, s->corner + 3*i, x);
        x[0] = convex_dot(n, x);
        lo = fmin(lo, x[0]);
        hi = fmax(hi, x[0]);
        if (lo < -close && hi > close) return 0;
        if (fabs(x[0]) <= close) on |= UINT64_C(1) << c;
    }
    for (c = 0; c < 3 && hi > close; c++) n[c] = -n[c];
    return lo < -close || hi > close ? on : 0;
}
/* Pairs of corners that two faces share. */
static inline int convex_join(convex_solid *s, const uint64_t *on) {
    int p, q, f, both;
    s->edges = 0;
    for (p = 0; p < s->corners; p++)
        for (q = p + 1; q < s->corners; q++) {
            for (f = both = 0; f < s->faces; f++) both += (int)(on[f] >> p & on[f] >> q & 1);
            if (both < 2) continue;
            if (both > 2 || s->edges == CONVEX_EDGES) return 0;
            s->edge[2*s->edges] = p;
            s->edge[2*s->edges++ + 1] = q;
        }
    return s->corners - s->edges + s->faces == 2;
}
/* The polyhedron of these 4 to 64 corners, by trying all triples; 0 when they are none: flat, or one of them inside, or
   on a face or an edge without being a corner. */
static inline int convex_hull(convex_solid *s, int count, const double *points) {
    uint64_t on[CONVEX_FACES], one;
    double n[3], close = 0;
    int i, j, k, f;
    if (count < 4 || count > CONVEX_CORNERS) return 0;
    memset(s, 0, sizeof *s);
    s->corners = count;
    memcpy(s->corner, points, (size_t)count*3*sizeof(double));
    for (i = 0; i < 3*count; i++) close = fmax(close, 1e-11*fabs(points[i] - points[i%3]));
    for (i = 0; i < count; i++)
        for (j = i + 1; j < count; j++)
            for (k = j + 1; k < count; k++) {
                one = convex_facet(s, i, j, k, close, n);
                for (f = 0; f < s->faces && one; f++) if ((on[f] & one) == one) one = 0;
                if (!one) continue;
                if (s->faces == CONVEX_FACES) return 0;
                on[s->faces] = one;
                memcpy(s->plane + 4*s->faces, n, sizeof n);
                s->plane[4*s->faces + 3] = convex_top(s, n);
                s->faces++;
            }
    return convex_join(s, on);
}
/* Stretches it along the axes. */
static inline void convex_stretch(convex_solid *s, double x, double y, double z) {
    const double by[3] = {x, y, z};
    int i, k;
    for (i = 0; i < s->corners; i++) for (k = 0; k < 3; k++) s->corner[3*i + k] *= by[k];
    for (i = 0; i < s->faces; i++) {
        double *n = s->plane + 4*i;
        for (k = 0; k < 3; k++) n[k] /= by[k];
        convex_unit(n);
        n[3] = convex_top(s, n);
    }
}
/* Rotates it about the origin by a matrix in rows, then moves it. */
static inline void convex_place(convex_solid *s, const double *R, const double *by) {
    double x[3];
    int i, k;
    for (i = 0; i < s->corners; i++) {
        memcpy(x, s->corner + 3*i, sizeof x);
        for (k = 0; k < 3; k++) s->corner[3*i + k] = convex_dot(R + 3*k, x) + by[k];
    }
    for (i = 0; i < s->faces; i++) {
        double *n = s->plane + 4*i;
        memcpy(x, n, sizeof x);
        for (k = 0; k < 3; k++) n[k] = convex_dot(R + 3*k, x);
        convex_unit(n);
        n[3] = convex_top(s, n);
    }
}
static inline void convex_move(convex_solid *s, double x, double y, double z) {
    const double one[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, by[3] = {x, y, z};
    convex_place(s, one, by);
}
/* The matrix of a quaternion, w first, of any length. */
static inline void convex_matrix(double w, double x, double y, double z, double *R) {
    const double f = 2/(w*w + x*x + y*y + z*z);
    R[0] = 1 - f*(y*y + z*z); R[1] = f*(x*y - w*z); R[2] = f*(x*z + w*y);
    R[3] = f*(x*y + w*z); R[4] = 1 - f*(x*x + z*z); R[5] = f*(y*z - w*x);
    R[6] = f*(x*z - w*y); R[7] = f*(y*z + w*x); R[8] = 1 - f*(x*x + y*y);
}
/* A box about the origin with these edges; corner i has the bits of i as signs. */
static inline void convex_box(convex_solid *s, double a, double b, double c) {
    double x[24];
    int i;
    for (i = 0; i < 24; i++) x[i] = i/3 >> i%3 & 1 ? 0.5 : -0.5;
    convex_hull(s, 8, x);
    convex_stretch(s, a, b, c);
}
/* Regular, their corners 1/2 from the origin. */
static inline void convex_tetrahedron(convex_solid *s) {
    static const double x[12] = {1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1};
    const double f = 0.5/sqrt(3.0);
    convex_hull(s, 4, x);
    convex_stretch(s, f, f, f);
}
static inline void convex_octahedron(convex_solid *s) {
    double x[18] = {0};
    int i;
    for (i = 0; i < 6; i++) x[3*i + i/2] = i%2 ? 0.5 : -0.5;
    convex_hull(s, 6, x);
}
/* Of 3 to 32 sides, corners on a circle of radius 1/2, from z = -1/2 to 1/2. */
static inline void convex_prism(convex_solid *s, int sides) {
    double x[3*CONVEX_CORNERS];
    int i;
    for (i = 0; i < 2*sides; i++) {
        x[3*i] = 0.5*cos(i%sides*6.283185307179586/sides);
        x[3*i + 1] = 0.5*sin(i%sides*6.283185307179586/sides);
        x[3*i + 2] = i < sides ? -0.5 : 0.5;
    }
    convex_hull(s, 2*sides, x);
}
/* Random points on a sphere of radius 1/2. */
static inline void convex_rock(convex_solid *s, uint64_t *state, int corners) {
    double x[3*CONVEX_CORNERS];
    int i;
    do for (i = 0; i < corners; i++) {
        const double z = 2*convex_random(state) - 1, f = 6.283185307179586*convex_random(state);
        x[3*i] = 0.5*sqrt(1 - z*z)*cos(f);
        x[3*i + 1] = 0.5*sqrt(1 - z*z)*sin(f);
        x[3*i + 2] = 0.5*z;
    } while (!convex_hull(s, corners, x));
}

/* ---- pairs ---- */
static inline double convex_power(uint64_t *state, double lo, double hi) {    /* uniform in its logarithm */
    return lo*pow(hi/lo, convex_random(state));
}
/* A body of this size along its longest axis, of an aspect ratio up to 50. */
static inline void convex_shape(convex_solid *s, uint64_t *state, double size) {
    const double flat = convex_power(state, 0.02, 1), mid = convex_power(state, flat, 1);
    const int kind = convex_below(state, 7), axis = convex_below(state, 3), plain = convex_below(state, 4) == 0;
    double by[3];
    switch (kind) {
    case 0: case 1: convex_box(s, 1, 1, 1); break;
    case 2: convex_tetrahedron(s); break;
    case 3: convex_octahedron(s); break;
    case 4: convex_prism(s, 3 + convex_below(state, 10)); break;
    default: convex_rock(s, state, kind == 5 ? 14 : 50);
    }
    by[axis] = size;
    by[(axis + 1)%3] = plain ? size : size*mid;
    by[(axis + 2)%3] = plain ? size : size*flat;
    convex_stretch(s, by[0], by[1], by[2]);
}
static inline void convex_turn(convex_solid *s, uint64_t *state) {
    const double none[3] = {0, 0, 0};
    double q[4], R[9];
    int k;
    for (k = 0; k < 4; k++) q[k] = 2*convex_random(state) - 1;
    convex_matrix(q[0] + 1e-9, q[1], q[2], q[3], R);
    convex_place(s, R, none);
}
/* A point of its surface, the way out there, and a direction along the surface. */
typedef struct convex_spot { double at[3], out[3], along[3]; } convex_spot;
enum { CONVEX_FACE, CONVEX_EDGE, CONVEX_CORNER };
/* Adds the normals of the faces that hold this point to `out`. */
static inline void convex_out(const convex_solid *s, const double *x, double close, double *out) {
    int f, k;
    for (k = 0; k < 3; k++) out[k] = 0;
    for (f = 0; f < s->faces; f++) {
        const double *n = s->plane + 4*f;
        for (k = 0; k < 3 && convex_dot(n, x) > n[3] - close; k++) out[k] += n[k];
    }
}
static inline convex_spot convex_spot_of(const convex_solid *s, uint64_t *state, int kind) {
    const convex_body view = convex_view(s);
    const double close = 1e-9*convex_radius(&view);
    const int f = convex_below(state, s->faces), e = convex_below(state, s->edges), c = convex_below(state, s->corners);
    const double share = 0.05 + 0.9*convex_random(state), *n = s->plane + 4*f;
    convex_spot spot;
    int i, k, count = 0;
    memset(&spot, 0, sizeof spot);
    if (kind == CONVEX_CORNER) {
        memcpy(spot.at, s->corner + 3*c, sizeof spot.at);
        convex_out(s, spot.at, close, spot.out);
    } else if (kind == CONVEX_EDGE) {
        const double *x = s->corner + 3*s->edge[2*e], *y = s->corner + 3*s->edge[2*e + 1];
        for (k = 0; k < 3; k++) spot.at[k] = x[k] + share*(y[k] - x[k]);
        convex_out(s, spot.at, close, spot.out);
        convex_minus(y, x, spot.along);
    } else {
        memcpy(spot.out, n, sizeof spot.out);
        for (i = 0; i < s->corners; i++) {
            const double *x = s->corner + 3*i;
            if (convex_dot(n, x) < n[3] - close) continue;
            if (count == 1) convex_minus(x, spot.at, spot.along);
            for (k = 0; k < 3; k++) spot.at[k] += x[k];
            count++;
        }
        for (k = 0; k < 3; k++) spot.at[k] /= count;
    }
    convex_unit(spot.out);
    if (kind == CONVEX_CORNER) {                /* any direction square to the way out */
        spot.along[fabs(spot.out[0]) < 0.6 ? 0 : 1] = 1;
        spot.along[2] = share;
    }
    for (i = 0; i < 2; i++) {                   /* twice: square to the last digit */
        const double off = convex_dot(spot.along, spot.out);
        for (k = 0; k < 3; k++) spot.along[k] -= off*spot.out[k];
        convex_unit(spot.along);
    }
    return spot;
}
/* Columns: out, along, and square to both. */
static inline void convex_frame(const convex_spot *spot, double *F) {
    double third[3];
    int k;
    convex_cross(spot->out, spot->along, third);
    for (k = 0; k < 3; k++) { F[3*k] = spot->out[k]; F[3*k + 1] = spot->along[k]; F[3*k + 2] = third[k]; }
}
/* Places b so that its spot stands `gap` over a's, facing it, rotated by `angle` about the way out and moved aside. */
static inline void convex_meet(convex_solid *b, const convex_spot *on_a, const convex_spot *on_b, double angle, double gap,
                               double aside) {
    const double c = cos(angle), s = sin(angle);
    convex_spot facing;
    double F[9], G[9], R[9], by[3], third[3];
    int i, j, k;
    convex_cross(on_a->out, on_a->along, third);
    for (k = 0; k < 3; k++) {
        facing.out[k] = -on_a->out[k];
        facing.along[k] = angle == 0 ? on_a->along[k] : c*on_a->along[k] + s*third[k];
    }
    convex_frame(&facing, F);
    convex_frame(on_b, G);
    for (i = 0; i < 3; i++) for (j = 0; j < 3; j++) R[3*i + j] = convex_dot(F + 3*i, G + 3*j);
    for (k = 0; k < 3; k++) by[k] = on_a->at[k] + gap*on_a->out[k] + aside*on_a->along[k] - convex_dot(R + 3*k, on_b->at);
    convex_place(b, R, by);
}
/* How far apart they are to be, by the size of the smaller: of ten draws three a good deal, two each 1e-3, 1e-6 and 1e-9 of
   it, and one nothing at all. */
static inline double convex_wanted(uint64_t *state, double size) {
    static const double share[10] = {0, 1e-3, 1e-3, 1e-6, 1e-6, 1e-9, 1e-9, 1, 1, 1};
    const int kind = convex_below(state, 10);
    const double sign = convex_below(state, 2) ? 1 : -1, part = convex_power(state, 1e-3, 0.3);
    return sign*size*share[kind]*(kind < 7 ? 1 : part);
}
enum { CONVEX_ANY, CONVEX_FACES_MEET, CONVEX_EDGES_ALONG, CONVEX_EDGES_CROSSED, CONVEX_CORNER_ON_FACE, CONVEX_CORNERS_MEET,
       CONVEX_CONCENTRIC, CONVEX_KINDS };
/* b in a random place beside a, then moved along the normal until the gap is the one wanted. */
static inline void convex_draw_any(convex_solid *a, convex_solid *b, uint64_t *state, double gap) {
    const convex_body one = convex_view(a), two = convex_view(b);
    const double far_off = convex_radius(&one) + convex_radius(&two);
    double way[3];
    convex_gap g;
    int k;
    for (k = 0; k < 3; k++) way[k] = 2*convex_random(state) - 1;
    convex_unit(way);
    convex_move(b, far_off*way[0], far_off*way[1], far_off*way[2]);
    for (k = 0; k < 2; k++) {
        g = convex_brute(&one, &two);
        g.gap -= gap;
        convex_move(b, -g.gap*g.normal[0], -g.gap*g.normal[1], -g.gap*g.normal[2]);
    }
}
/* Two bodies and where they are; returns the kind of meeting. */
static inline int convex_pair(convex_solid *a, convex_solid *b, uint64_t *state) {
    static const int on_a[6] = {0, CONVEX_FACE, CONVEX_EDGE, CONVEX_EDGE, CONVEX_FACE, CONVEX_CORNER};
    static const int on_b[6] = {0, CONVEX_FACE, CONVEX_EDGE, CONVEX_EDGE, CONVEX_CORNER, CONVEX_CORNER};
    const int kind = convex_below(state, CONVEX_KINDS), swapped = convex_below(state, 2), aligned = convex_below(state, 2);
    const double large = convex_power(state, 1e-5, 10), small = fmax(large/convex_power(state, 1, 100), 1e-5);
    const double gap = convex_wanted(state, small), aside = 0.2*small*convex_random(state);
    const double angle = kind == CONVEX_EDGES_ALONG ? 0 : kind == CONVEX_FACES_MEET && aligned ? 0 : 6*convex_random(state);
    double by[3];
    int k;
    convex_shape(a, state, swapped ? small : large);
    convex_shape(b, state, swapped ? large : small);
    if (convex_below(state, 4)) convex_turn(a, state);
    if (kind == CONVEX_ANY || kind == CONVEX_CONCENTRIC) {
        if (!aligned) convex_turn(b, state);
        if (kind == CONVEX_ANY) convex_draw_any(a, b, state, gap);
    } else {
        const convex_spot one = convex_spot_of(a, state, on_a[kind]), two = convex_spot_of(b, state, on_b[kind]);
        convex_meet(b, &one, &two, angle, gap, kind == CONVEX_FACES_MEET || kind == CONVEX_CORNER_ON_FACE ? aside : 0);
    }
    for (k = 0; k < 3; k++) by[k] = aligned && kind == CONVEX_CONCENTRIC ? 0 : large*(2*convex_random(state) - 1);
    convex_move(a, by[0], by[1], by[2]);
    convex_move(b, by[0], by[1], by[2]);
    return kind;
}
#endif
