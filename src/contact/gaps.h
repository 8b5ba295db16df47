/* ---------------------------------------------------------------------------------------------
   >>gaps
   Distance or penetration depth of two convex polyhedra, and their contact manifold: what impulses,
   and laws with a range, need of polyhedra. Geometry only, from the corners. For x of body A and y
   of body B the differences y - x fill a polytope D (the Minkowski difference). The bodies overlap
   if D contains the origin, and the point of D's surface nearest to the origin gives gap and
   normal.

   If they are apart, that point is found by iterating over simplexes of D's corners, adding the
   corner farthest towards the origin each time [GJK88]. If they overlap, a polytope of such corners
   grows about the origin until its face nearest to the origin is one of D's [BER03], which gives
   the shortest separating translation. Both iterations end at a corner that is already included, so
   the only tolerance is rounding. Normals are those of faces of D, not of the short vector to the
   origin, and remain valid at gap 0. If a face of one body is perpendicular to the normal, the
   opposite face of the other is clipped to its outline; at most four of the resulting points make
   the contact. tests/contact/test_convex.c checks this against all separating planes, and against
   portals.
   --------------------------------------------------------------------------------------------- */

/* Two bodies touch if their gap is 0 but for rounding, up to this part of their size below 0. */
#define DEMI_TOUCHING (DEMI_SINGLE ? 1e-5 : 1e-9)

/* A support vertex, that is a corner of D: corner b of B minus corner a of A. */
typedef struct demi_lead { demi_d3 x; int a, b; } demi_lead;
/* Up to four corners of D. The point nearest to the origin is the sum of part x; the parts add up
   to 1. */
typedef struct demi_simplex { int count; demi_lead at[4]; double part[4]; } demi_simplex;

/* Returns the corner of a body that is farthest along n. */
static int demi_solid_far(const demi_solid *s, demi_d3 n) {
    double most = -1e300;
    int i, far = 0;
    for (i = 0; i < s->corners; i++) {
        const double d = demi_d3_dot(n, s->corner[i]);
        if (d > most) { most = d; far = i; }
    }
    return far;
}
/* Returns the corner of D that is farthest along n. */
static demi_lead demi_lead_along(const demi_solid *a, const demi_solid *b, demi_d3 n) {
    demi_lead lead;
    lead.a = demi_solid_far(a, demi_d3_scale(n, -1));
    lead.b = demi_solid_far(b, n);
    lead.x = demi_d3_sub(b->corner[lead.b], a->corner[lead.a]);
    return lead;
}
/* Sets the parts of both ends of a segment in its point nearest to the origin. Returns the squared
   distance of that point. */
static double demi_near_segment(demi_d3 p, demi_d3 q, double *part) {
    const demi_d3 e = demi_d3_sub(q, p);
    const double t = -demi_d3_dot(p, e)/demi_d3_square(e);
    part[1] = t > 0 ? t < 1 ? t : 1 : 0;        /* 0 for a point */
    part[0] = 1 - part[1];
    return demi_d3_square(demi_d3_plus(demi_d3_scale(p, part[0]), part[1], q));
}
/* The point of a triangle with the given parts. */
static demi_d3 demi_triangle_point(const double *part, demi_d3 p, demi_d3 q, demi_d3 r) {
    return demi_d3_plus(demi_d3_plus(demi_d3_scale(p, part[0]), part[1], q), part[2], r);
}
/* Sets the parts of the corners of a triangle in its point nearest to the origin. */
static void demi_near_triangle(demi_d3 p, demi_d3 q, demi_d3 r, double *part) {
    const demi_d3 corner[3] = {p, q, r}, e = demi_d3_sub(q, p), f = demi_d3_sub(r, p);
    const double ep = -demi_d3_dot(e, p), eq = -demi_d3_dot(e, q), er = -demi_d3_dot(e, r);
    const double fp = -demi_d3_dot(f, p), fq = -demi_d3_dot(f, q), fr = -demi_d3_dot(f, r);
    const double a = eq*fr - er*fq;             /* areas over the sides opposite to p, q and r */
    const double b = er*fp - ep*fr, c = ep*fq - eq*fp;
    int i;
    part[0] = part[1] = part[2] = 0;
    if (!(demi_d3_square(demi_d3_cross(e, f)) >
          1e-16*demi_d3_square(e)*demi_d3_square(f))) {         /* collinear */
        double least = 1e300;
        for (i = 0; i < 3; i++) {
            double t[2];
            const double d2 = demi_near_segment(corner[i], corner[(i + 1)%3], t);
            if (!(d2 < least)) continue;
            least = d2;
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
/* The sides of a tetrahedron: three corners and the opposite one. */
static const int demi_sides[4][4] = {{0, 1, 2, 3}, {0, 3, 1, 2}, {1, 3, 2, 0}, {0, 2, 3, 1}};
/* Finds the point v of a simplex nearest to the origin and drops corners that do not contribute to
   it. Returns its squared distance, or 0 with all four corners if the origin is inside. */
static double demi_simplex_near(demi_simplex *s, demi_d3 *v) {
    double part[4] = {1, 0, 0, 0}, tried[3], least = 1e300;
    int i, k, left = 0;
    if (s->count == 2) demi_near_segment(s->at[0].x, s->at[1].x, part);
    else if (s->count == 3)
        demi_near_triangle(s->at[0].x, s->at[1].x, s->at[2].x, part);
    for (i = 0; i < 4 && s->count == 4; i++) {
        const int *side = demi_sides[i];
        const demi_d3 p = s->at[side[0]].x, q = s->at[side[1]].x, r = s->at[side[2]].x;
        const demi_d3 n = demi_d3_normal(p, q, r), d = demi_d3_sub(s->at[side[3]].x, p);
        const double high = demi_d3_dot(n, d);
        double d2;
        if (high*high > 1e-20*demi_d3_square(n)*demi_d3_square(d) &&   /* not flat */
            -demi_d3_dot(n, p)*high > 0) continue;      /* on the same side as the fourth corner */
        demi_near_triangle(p, q, r, tried);
        d2 = demi_d3_square(demi_triangle_point(tried, p, q, r));
        if (!(d2 < least)) continue;
        least = d2;
        part[side[3]] = 0;
        for (k = 0; k < 3; k++) part[side[k]] = tried[k];
    }
    if (s->count == 4 && least > 1e299) return 0;
    *v = demi_d(0, 0, 0);
    for (i = 0; i < s->count; i++) {
        if (!(part[i] > 0)) continue;
        *v = demi_d3_plus(*v, part[i], s->at[i].x);
        s->at[left] = s->at[i];
        s->part[left++] = part[i];
    }
    s->count = left;
    return demi_d3_square(*v);
}
/* Returns the unit normal of a simplex of three corners, on the side of v; of others v itself, made
   unit. */
static demi_d3 demi_simplex_normal(const demi_simplex *s, demi_d3 v) {
    if (s->count == 3) {
        const demi_d3 n = demi_d3_normal(s->at[0].x, s->at[1].x, s->at[2].x);
        v = demi_d3_dot(n, v) < 0 ? demi_d3_scale(n, -1) : n;
    }
    return demi_d3_unit(v);
}
static int demi_lead_known(const demi_lead *at, int count, const demi_lead *w) {
    int i;
    for (i = 0; i < count; i++) if (at[i].a == w->a && at[i].b == w->b) return 1;
    return 0;
}
/* True if the two bodies are apart by more than tiny, m. n: on entry a direction to start with, on
   return the unit normal from a to b, or some normal of a slab wider than `range` (m) between them.
   GJK. */
static int demi_solids_apart(const demi_solid *a, const demi_solid *b, double tiny, double range,
                             demi_d3 *n, demi_simplex *s) {
    demi_d3 v = *n, had_v;
    double far = 1e300;
    demi_simplex had;
    int turn;
    if (!(demi_d3_square(v) > 0)) v = demi_d3_sub(b->centre, a->centre);
    if (!(demi_d3_square(v) > 0)) v.z = 1;
    s->count = 0;
    for (turn = 0; turn < 100; turn++) {
        double now;
        demi_lead *w = &s->at[s->count];
        *w = demi_lead_along(a, b, demi_d3_scale(v, -1));
        if (demi_d3_dot(v, w->x) > range*demi_d3_length(v)) break;
        if (turn && (far - demi_d3_dot(v, w->x) <= 1e-14*far ||
                     demi_lead_known(s->at, s->count, w))) break;
        had = *s;
        had_v = v;
        s->count++;
        now = demi_simplex_near(s, &v);
        if (!(now > tiny*tiny)) return 0;
        if (!(now < far)) {                     /* rounding: no nearer */
            *s = had;
            v = had_v;
            break;
        }
        far = now;
    }
    *n = demi_simplex_normal(s, v);
    return fabs(n->x) <= 1 && fabs(n->y) <= 1 && fabs(n->z) <= 1;
}

/* --- overlap: a polytope that grows about the origin (EPA) --- */

enum { DEMI_POLYTOPE = 120 };                   /* largest number of corners */
/* A convex polytope of corners of D with triangular faces. */
typedef struct demi_polytope {
    int corners, faces;
    double size;                   /* m, of both bodies: scale of round-off */
    demi_lead at[DEMI_POLYTOPE];
    struct {
        demi_d3 n;                 /* unit, outward; 0: the face has no area */
        double at;                 /* n.x */
        double blur;               /* error of n, rad: large if thin or small */
        int corner[3];
    } face[2*DEMI_POLYTOPE];
} demi_polytope;
/* Sets face i. One without area never counts as the nearest and is visible from nowhere. */
static void demi_polytope_face(demi_polytope *p, int i, int a, int b, int c) {
    const demi_d3 e = demi_d3_sub(p->at[b].x, p->at[a].x), f = demi_d3_sub(p->at[c].x, p->at[a].x);
    const demi_d3 n = demi_d3_cross(e, f);
    const double ee = demi_d3_square(e), ff = demi_d3_square(f), area = demi_d3_length(n);
    p->face[i].corner[0] = a; p->face[i].corner[1] = b; p->face[i].corner[2] = c;
    p->face[i].n = demi_d(0, 0, 0);
    p->face[i].at = 1e300;
    p->face[i].blur = 0;
    if (area > 1e-15*sqrt(ee*ff)) {
        const double gg = demi_d3_square(demi_d3_sub(f, e));
        p->face[i].n = demi_d3_unit(n);
        p->face[i].at = demi_d3_dot(p->face[i].n, p->at[a].x);
        /* over the least height */
        p->face[i].blur = 1e-15*p->size*sqrt(DEMI_MAX(ee, DEMI_MAX(ff, gg)))/area;
    }
}
/* Distance, m, of x from the point, line or plane of the first corners. */
static double demi_polytope_off(const demi_polytope *p, demi_d3 x) {
    const demi_d3 d = demi_d3_sub(x, p->at[0].x);
    if (p->corners == 1) return demi_d3_length(d);
    const demi_d3 e = demi_d3_sub(p->at[1].x, p->at[0].x);
    if (p->corners == 2) return sqrt(demi_d3_square(demi_d3_cross(e, d))/demi_d3_square(e));
    return fabs(demi_d3_dot(demi_d3_unit(demi_d3_normal(p->at[0].x, p->at[1].x, p->at[2].x)), d));
}
/* Makes the first tetrahedron from the simplex at which GJK ended. Returns 0 if D is flat. */
static int demi_polytope_begin(const demi_solid *a, const demi_solid *b, const demi_simplex *s,
                               double size, demi_polytope *p) {
    int i;
    p->corners = s->count;
    p->size = size;
    for (i = 0; i < s->count; i++) p->at[i] = s->at[i];
    if (p->corners == 4) {                      /* it may be flat */
        p->corners = 3;
        if (demi_polytope_off(p, p->at[3].x) > 1e-9*size) p->corners = 4;
    }
    while (p->corners < 4) {
        double most = 0;
        demi_lead best;
        memset(&best, 0, sizeof best);
        for (i = 0; i < 6; i++) {
            demi_d3 way = demi_d(i/2 == 0, i/2 == 1, i/2 == 2);
            demi_lead w;
            double off;
            if (p->corners == 2) way = demi_d3_cross(demi_d3_sub(p->at[1].x, p->at[0].x), way);
            if (p->corners == 3) way = demi_d3_normal(p->at[0].x, p->at[1].x, p->at[2].x);
            w = demi_lead_along(a, b, demi_d3_scale(way, i & 1 ? -1 : 1));
            off = demi_polytope_off(p, w.x);
            if (off > most) { most = off; best = w; }
        }
        if (!(most > 1e-13*size)) return 0;
        p->at[p->corners++] = best;
    }
    for (i = 0; i < 4; i++) {
        const int *c = demi_sides[i];
        demi_polytope_face(p, i, c[0], c[1], c[2]);
        if (demi_d3_dot(p->face[i].n, p->at[c[3]].x) > p->face[i].at)
            demi_polytope_face(p, i, c[0], c[2], c[1]);
    }
    p->faces = 4;
    return 1;
}
/* Height, m, of a corner above the plane of face i, minus an allowance for round-off. Without it,
   coplanar faces could disagree on whether they see the corner, and the faces that join it to their
   rim would fold. most: largest allowance, m. */
static double demi_polytope_over(const demi_polytope *p, int i, const demi_lead *w, double most) {
    const demi_d3 d = demi_d3_sub(w->x, p->at[p->face[i].corner[0]].x);
    return demi_d3_dot(p->face[i].n, d) - DEMI_MIN(p->face[i].blur*demi_d3_length(d), most);
}
/* Adds a corner: the faces that see it, and always the nearest one, are replaced by faces that join
   it to their rim. Returns 0 if there is no room. */
static int demi_polytope_take(demi_polytope *p, int nearest, const demi_lead *w) {
    int rim[2*DEMI_POLYTOPE][2], count = 0, left = 0, i, k, e;
    unsigned char seen[2*DEMI_POLYTOPE];
    if (p->corners == DEMI_POLYTOPE) return 0;
    for (i = 0; i < p->faces; i++) {
        seen[i] = i == nearest || demi_polytope_over(p, i, w, 1e300) > 1e-14*p->size;
        if (!seen[i]) { left++; continue; }
        for (k = 0; k < 3; k++) {               /* a side of two such faces is not on the rim */
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
/* Sets n, from a to b, to the direction of the shortest translation that separates two overlapping
   bodies (EPA). If it ends early (rounding, no room), n is the best found, which also separates
   them. */
static void demi_solids_part(const demi_solid *a, const demi_solid *b, double size, demi_d3 *n,
                             demi_simplex *s) {
    demi_polytope p;
    demi_lead w;
    double least = 1e300;
    int i, k, best;
    if (!demi_polytope_begin(a, b, s, size, &p)) {
        if (!(demi_d3_square(*n) > 0)) n->z = 1;
        *n = demi_d3_unit(*n);
        return;
    }
    do {
        double way;
        for (i = 1, best = 0; i < p.faces; i++)
            if (p.face[i].at < p.face[best].at) best = i;
        w = demi_lead_along(a, b, p.face[best].n);
        way = demi_d3_dot(p.face[best].n, w.x);
        for (k = 0; k < 3 && way < least; k++) s->at[k] = p.at[p.face[best].corner[k]];
        if (way < least) *n = demi_d3_scale(p.face[best].n, -1);
        least = DEMI_MIN(least, way);
    } while (demi_polytope_over(&p, best, &w, 1e-9*size) > 1e-13*size &&
             !demi_lead_known(p.at, p.corners, &w) && demi_polytope_take(&p, best, &w));
    s->count = 3;
    demi_near_triangle(s->at[0].x, s->at[1].x, s->at[2].x, s->part);
}
/* Width, m, of the slab perpendicular to n between the bodies; negative: their overlap along n. */
static double demi_solids_slab(const demi_solid *a, const demi_solid *b, demi_d3 n) {
    const int far_a = demi_solid_far(a, n), far_b = demi_solid_far(b, demi_d3_scale(n, -1));
    return demi_d3_dot(n, demi_d3_sub(b->corner[far_b], a->corner[far_a]));
}
/* Distance of the farthest corner from the centre, m. */
static double demi_solid_radius(const demi_solid *s) {
    double far2 = 0;
    int i;
    for (i = 0; i < s->corners; i++)
        far2 = DEMI_MAX(far2, demi_d3_square(demi_d3_sub(s->corner[i], s->centre)));
    return sqrt(far2);
}
/* Returns the width of the slab along n or, if that is larger, along a normal of a face; then n and
   s are that. EPA may end early where faces touch to round-off, with a direction along which bodies
   overlap by far more. */
static double demi_solids_slab_best(const demi_solid *a, const demi_solid *b, demi_d3 *n,
                                    demi_simplex *s) {
    double most = demi_solids_slab(a, b, *n);
    int k, f, best = -1;
    for (k = 0; k < 2; k++)
        for (f = 0; f < (k ? b : a)->faces; f++) {
            const demi_solid *of = k ? b : a;
            const demi_d3 up = demi_d3_scale(of->face[f].slope, (k ? -1 : 1)*of->face[f].high);
            const double wide = demi_solids_slab(a, b, up);
            if (!(wide > most)) continue;
            most = wide;
            *n = up;
            best = f;
        }
    if (best < 0) return most;
    s->count = 1;
    s->at[0] = demi_lead_along(a, b, demi_d3_scale(*n, -1));
    s->part[0] = 1;
    return most;
}
/* Returns the gap between the two, m; negative: their penetration depth; above `range` any number
   from there to the gap. n: on entry a direction to start with, or 0; on return the unit normal
   from a to b. s: the corners that define it. */
static double demi_solids_gap(const demi_solid *a, const demi_solid *b, double range, demi_d3 *n,
                              demi_simplex *s) {
    const double ra = demi_solid_radius(a), rb = demi_solid_radius(b), size = ra + rb;
    double deep;
    if (demi_solids_apart(a, b, DEMI_MAX(1e-7*DEMI_MIN(ra, rb), 1e-14*size), range, n, s)) {
        const double gap = demi_solids_slab(a, b, *n);
        if (gap > 0) return gap;
    }
    demi_solids_part(a, b, size, n, s);
    deep = -demi_solids_slab(a, b, *n);
    return deep < 1e-3*size ? -deep : demi_solids_slab_best(a, b, n, s);
}

/* --- contact manifold --- */

/* How much a point that is `off` (m) aside of others matters, for demi_spots_pick. Points that
   touch (gap of at most `touch`, m) come first, the farthest of them before others. Of the rest,
   those come first that the smallest rotation brings into contact. far: largest distance, m. */
static double demi_spot_matters(double off, double gap, double touch, double far) {
    if (!(off > 1e-6*far)) return 0;
    return gap > touch ? off/far*touch/gap : 1 + off/far;
}
/* Picks up to four of many points in a plane across n: the deepest, and then by demi_spot_matters
   one by its distance from the deepest, and on either side of the line through both one by its
   distance from that line; if one side has none, one by its distance from the nearest of the three.
   Returns their number. The range of the search changes nothing while four points touch. */
static int demi_spots_pick(const demi_d3 *x, const double *gap, int count, demi_d3 n, int *out) {
    demi_d3 across;
    double far = 0, touch, most = 0, side[2] = {0, 0};
    int i, k, pass, picked = 2, best[2] = {-1, -1};
    if (count <= 4) {
        for (i = 0; i < count; i++) out[i] = i;
        return count;
    }
    out[0] = out[1] = 0;
    for (i = 1; i < count; i++) if (gap[i] < gap[out[0]]) out[0] = i;
    for (pass = 0, touch = 0; pass < 2; pass++) {
        for (i = 0; i < count; i++) {
            const double off = demi_d3_length(demi_d3_cross(n, demi_d3_sub(x[i], x[out[0]])));
            const double matters = demi_spot_matters(off, gap[i], touch, far);
            if (!pass) far = DEMI_MAX(far, off);
            else if (matters > most) { most = matters; out[1] = i; }
        }
        touch = DEMI_MAX(gap[out[0]], 0) + 1e-4*far;
    }
    if (!(most > 0)) return 1;
    across = demi_d3_unit(demi_d3_cross(n, demi_d3_sub(x[out[1]], x[out[0]])));
    for (i = 0; i < count; i++) {
        const double off = demi_d3_dot(across, demi_d3_sub(x[i], x[out[0]]));
        const double matters = demi_spot_matters(fabs(off), gap[i], touch, far);
        k = off < 0;
        if (matters > side[k]) { side[k] = matters; best[k] = i; }
    }
    for (k = 0; k < 2; k++) if (best[k] >= 0) out[picked++] = best[k];
    for (i = 0, most = 0; i < count && picked == 3; i++) {
        double off = far, matters;
        for (k = 0; k < 3; k++)
            off = DEMI_MIN(off, demi_d3_length(demi_d3_cross(n, demi_d3_sub(x[i], x[out[k]]))));
        matters = demi_spot_matters(off, gap[i], touch, far);
        if (matters > most) { most = matters; out[3] = i; }
    }
    return picked + (picked == 3 && most > 0);
}
/* Keeps those of `count` points whose gaps are below range, at most four. Returns their number. */
static int demi_spots_take(demi_spots *out, demi_d3 *x, double *gap, int count, double range,
                           demi_d3 n) {
    int i, left = 0, picked[4];
    for (i = 0; i < count; i++) {
        if (!(gap[i] < range)) continue;
        x[left] = x[i];
        gap[left++] = gap[i];
    }
    out->count = demi_spots_pick(x, gap, left, n, picked);
    for (i = 0; i < out->count; i++) {
        out->x[i] = x[picked[i]];
        out->gap[i] = gap[picked[i]];
    }
    return out->count;
}
/* Returns the face whose normal is most nearly along n. *along: the cosine. */
static int demi_solid_facing(const demi_solid *s, demi_d3 n, double *along) {
    int f, best = -1;
    *along = -2;
    for (f = 0; f < s->faces; f++) {
        const double c = demi_d3_dot(s->face[f].slope, n)*s->face[f].high;
        if (c > *along) { *along = c; best = f; }
    }
    return best;
}
/* Clips the face of b opposite to face f of a to the outline of f. Returns the number of points;
   gap: their gaps from the plane of f. */
static int demi_faces_over(const demi_solid *a, int f, const demi_solid *b, demi_d3 *x,
                           double *gap, demi_d3 *n) {
    const demi_d3 up = *n = demi_d3_scale(a->face[f].slope, a->face[f].high);
    double along;
    const int g = demi_solid_facing(b, demi_d3_scale(up, -1), &along);
    int i, count = 0;
    if (g < 0) return 0;
    for (i = b->rim[g]; i < b->rim[g + 1]; i++) x[count++] = demi_solid_corner(b, g, i);
    for (i = a->rim[f]; i < a->rim[f + 1] && count; i++) {
        const demi_d3 o = demi_solid_corner(a, f, i);
        const demi_d3 e = demi_d3_sub(demi_solid_corner(a, f, i + 1), o);
        count = demi_polygon_clip(x, count, demi_d3_cross(up, e), o);
    }
    for (i = 0; i < count; i++) {
        gap[i] = demi_d3_dot(up, demi_d3_sub(x[i], demi_solid_corner(a, f, a->rim[f])));
        x[i] = demi_d3_plus(x[i], -gap[i]/2, up);
    }
    return count;
}
/* Finds the contact manifold of two bodies with the gap `all` along n, which the corners s define.
   Returns the number of points. facet: b is flat, and its plane takes precedence. */
static int demi_solids_manifold(const demi_solid *a, const demi_solid *b, int facet, double range,
                                double all, demi_d3 n, const demi_simplex *s, demi_spots *out) {
    demi_d3 x[DEMI_SECTION], back;
    double gap[DEMI_SECTION], on_a, on_b;
    int fa, fb, i, count = 0;
    out->normal = n;
    fa = demi_solid_facing(a, n, &on_a);
    fb = demi_solid_facing(b, demi_d3_scale(n, -1), &on_b);
    if (on_b >= DEMI_FLUSH && (facet || on_b > on_a + 1e-9)) {
        count = demi_faces_over(b, fb, a, x, gap, &back);
        out->normal = demi_d3_scale(back, -1);
    } else if (on_a >= DEMI_FLUSH) count = demi_faces_over(a, fa, b, x, gap, &out->normal);
    if (demi_spots_take(out, x, gap, count, range, out->normal)) return out->count;
    out->normal = n;                            /* corners, edges */
    out->x[0] = demi_d(0, 0, 0);
    for (i = 0; i < s->count; i++) {
        const demi_d3 twice = demi_d3_add(a->corner[s->at[i].a], b->corner[s->at[i].b]);
        out->x[0] = demi_d3_plus(out->x[0], s->part[i]/2, twice);
    }
    out->gap[0] = all;
    return out->count = 1;
}
/* The same, or 0 if they are farther apart than `range`. guess: the normal of the last step, or 0.
   s: on return the corners that define the gap. */
static int demi_solids_spots(const demi_solid *a, const demi_solid *b, int facet, double range,
                             demi_d3 guess, demi_simplex *s, demi_spots *out) {
    demi_d3 n = guess;
    const double all = demi_solids_gap(a, b, range, &n, s);
    out->count = 0;
    out->normal = n;
    return all < range ? demi_solids_manifold(a, b, facet, range, all, n, s, out) : 0;
}
/* Moves the point of least gap, of `count` >= 1, to where a law with a range acts, and returns its
   index. If other points are almost as near (an edge or a face parallel to the other body), that is
   the mean of them all, because none of them is the nearest for good. Their weights fall from 1 to
   0 within `band` (m) above the least gap. A point that was found twice counts once. */
static int demi_spots_nearest(demi_d3 *x, const double *gap, int count, double band) {
    demi_d3 sum = demi_d(0, 0, 0);
    double all = 0;
    int i, k, nearest = 0;
    for (k = 1; k < count; k++) if (gap[k] < gap[nearest]) nearest = k;
    for (k = 0; k < count; k++) {
        const double part = 1 - (gap[k] - gap[nearest])/band;
        for (i = 0; i < k && demi_d3_length(demi_d3_sub(x[i], x[k])) > band; i++) continue;
        if (i < k || !(part > 0)) continue;
        sum = demi_d3_plus(sum, part, x[k]);
        all += part;
    }
    if (all > 1) x[nearest] = demi_d3_scale(sum, 1/all);
    return nearest;
}
