/* ---------------------------------------------------------------------------------------------
   >>touch
   Geometry of contact points: where a sphere, or a body mapped to one, touches a wall element, and
   which of the overlapped elements count. (Two spheres: see demi_touch_one in >>respond;
   candidates: see >>lists.) It uses no law and no material, works in the frame of the wall, and
   returns contact points: normal, point, overlap, weight (`share`). Several facets with the same
   contact point give one; contact points whose weights cancel are removed before a law is called.
   The memory was reserved when the candidate list was built.
   --------------------------------------------------------------------------------------------- */

/* --- surfaces of facets: nearest contact points and their weights (>>facets) --- */

/* Contact points found so far for one body and one wall. `point` is relative to the body's centre;
   `overlap` is the distance. Both are in the body's measure: an ellipsoid is scaled to the unit
   sphere. A few are searched one by one, many by a hash table of their numbers. */
typedef struct demi_places {
    demi_touching *at;
    int32_t *table;                /* mask + 1 entries: 1 + index into at, 0: free; or null */
    uint32_t mask;
    int count, offset;             /* offset: added to numbers, one range per image */
} demi_places;
/* Adds contact point `number` at d with a weight. If it is known, only the weights are added. */
static void demi_places_add(demi_places *p, int32_t number, dem_real weight, dem_vec3 d,
                            dem_real d2) {
    uint32_t slot = (uint32_t)(number + p->offset)*UINT32_C(2654435769) & p->mask;
    int i = 0;
    number += p->offset;
    if (!p->table) while (i < p->count && p->at[i].element != number) i++;
    else {
        for (; p->table[slot]; slot = (slot + 1) & p->mask)
            if (p->at[p->table[slot] - 1].element == number) break;
        i = p->table[slot] ? p->table[slot] - 1 : p->count;
        p->table[slot] = i + 1;
    }
    if (i < p->count) { p->at[i].share += weight; return; }
    p->at[i].element = number;
    p->at[i].share = weight;
    p->at[i].point = d;
    p->at[i].overlap = DEMI_SQRT(d2);
    p->count++;
}
/* Removes contact points whose weights cancel, and merges those that coincide to rounding (of a
   corner and its periodic image). */
static void demi_places_merge(demi_places *p, dem_real near_by) {
    int i, k, count = 0;
    for (i = 0; i < p->count; i++) {
        demi_touching t = p->at[i];
        if (t.share > DEM_R(-1e-3) && t.share < DEM_R(1e-3)) continue;
        for (k = 0; k < count; k++) {
            const dem_vec3 d = demi_sub(t.point, p->at[k].point);
            if (demi_dot(d, d) <= near_by*near_by) break;
        }
        if (k == count) { p->at[count++] = t; continue; }
        p->at[k].share += t.share;              /* the lower number: stable from step to step */
        p->at[k].element = DEMI_MIN(p->at[k].element, t.element);
    }
    for (i = k = 0; i < count; i++)
        if (p->at[i].share < DEM_R(-1e-3) || p->at[i].share > DEM_R(1e-3)) p->at[k++] = p->at[i];
    p->count = k;
}
/* The number of the contact point of element e, from `where` of demi_facet_point. */
DEM_INLINE int32_t demi_facet_number(const demi_wall *wall, int e, int n, int where) {
    const int edges = wall->element_count;
    return where == 0 ? e : where < 4 ? edges + wall->edges[3*e + where - 1]
        : edges + wall->edge_count + wall->corners[n*e + where - 4];
}
/* Adds the contact point of an element whose neighbours are all out of reach. No correction for
   edges and corners is needed. */
DEM_INLINE void demi_facet_alone(const demi_wall *wall, int e, dem_vec3 x, dem_real within,
                                 demi_places *p) {
    dem_vec3 y[3];
    int where;
    const int n = demi_facet_seen(wall, e, x, 0, y);
    const dem_vec3 d = demi_facet_point(y, n, &where);
    const dem_real d2 = demi_dot(d, d);
    if (d2 < within*within && wall->weight[e] > 0)
        demi_places_add(p, demi_facet_number(wall, e, n, where), wall->weight[e], d, d2);
}
/* Adds the contact points nearer than `within` of element e and of the edges and corners that it
   owns. */
DEM_INLINE void demi_facet_places(const demi_wall *wall, int e, dem_vec3 x, const demi_part *part,
                                  dem_real within, demi_places *p) {
    const int edges = wall->element_count, corners = edges + wall->edge_count;
    const int own = wall->owns[e];
    const dem_real *weight = wall->weight, most = within*within;
    dem_vec3 y[3], d;
    dem_real add = weight[e], d2;
    int where, done = 0, n, k, at;
    n = demi_facet_seen(wall, e, x, part, y);
    d = demi_facet_point(y, n, &where);
    d2 = demi_dot(d, d);
    if (!(d2 < most)) return;                   /* nor are its edges nearer */
    if (where >= 1 && where <= 3 && own >> (where - 1) & 1) {
        add += weight[edges + wall->edges[3*e + where - 1]];       /* the same point */
        done = where;
    }
    if (add < 0 || add > 0)
        demi_places_add(p, demi_facet_number(wall, e, n, where), add, d, d2);
    for (k = 0; k < 3 && n == 3 && own & 7; k++) {
        const dem_real count = weight[edges + wall->edges[3*e + k]];
        if (!(own >> k & 1) || done == k + 1 || !(count < 0 || count > 0)) continue;
        d = demi_side_point(y[k], y[(k + 1)%3], k, (k + 1)%3, &at);
        d2 = demi_dot(d, d);
        if (d2 < most)
            demi_places_add(p, at < 4 ? edges + wall->edges[3*e + k]
                       : corners + wall->corners[3*e + at - 4], count, d, d2);
    }
    for (k = 0; k < n && own >> 3; k++) {
        const int32_t number = corners + wall->corners[n*e + k];
        if (!(own >> (3 + k) & 1) || !(weight[number] < 0 || weight[number] > 0)) continue;
        d2 = demi_dot(y[k], y[k]);
        if (d2 < most) demi_places_add(p, number, weight[number], y[k], d2);
    }
}
/* --- rings. If the part of a surface within reach of a sphere closes to a ring, at the rim of a
   hole or in a funnel, its Euler characteristic is 0 and there would be no force. A ring counts as
   one contact, so there
           E = integral of pieces(s) U'(r - s) ds = U(facets) - U(links of a forest)
   pieces: connected pieces, that is chi plus the number of open rings; forest: the sides and
   corners that join facets, nearest first, of which only those count that join what was not yet
   joined (Kruskal). With U1 the energy of the nearest facet, X the energy by >>facets and P that by
   pieces, D = P - X >= 0 is what rings removed, and
           E = X + D h(D/U1),    h(q) = (3 - 2 t) t^2, t = 2 q - 1/2 within 0 .. 1
   A dimple that is reached down to its tip is an almost closed ring: D is small, and E is X, which
   is smooth. An open ring counts as one piece; which of its sides are nearest may change at any
   moment, as on the medial line of a single wall. Energy is conserved in both cases. Where a
   surface continues in its periodic images, or in the next cell of a tessellation, a ring may
   extend over several of these: what they share has one number. --- */
/* Orders links: sides before corners, then by number and facet. */
static int demi_link_compare(const void *x, const void *y) {
    const demi_link *a = (const demi_link *)x, *b = (const demi_link *)y;
    if (a->corner != b->corner) return a->corner < b->corner ? -1 : 1;
    if (a->number != b->number) return a->number < b->number ? -1 : 1;
    return a->facet < b->facet ? -1 : a->facet > b->facet;
}
/* Orders links by distance, then as above. */
static int demi_link_nearer(const void *x, const void *y) {
    const demi_link *a = (const demi_link *)x, *b = (const demi_link *)y;
    if (a->distance < b->distance) return -1;
    return a->distance > b->distance ? 1 : demi_link_compare(x, y);
}
/* Returns the root of facet i (union and find). */
static int demi_link_root(demi_link *link, int i) {
    while (link[i].root != i) i = link[i].root = link[link[i].root].root;
    return i;
}
/* The facets within reach, the links of their sides and corners, and the nearest contact point. */
typedef struct demi_ring {
    demi_link *link;
    int facets, links;
    int32_t number, offset;        /* offset: added to numbers, as in demi_places */
    dem_real distance;
    dem_vec3 point;
} demi_ring;
/* Adds a side (b: its other end) or corner (b null) of the last facet, if it is within reach: its
   numbers and nearest point. The result is the same, to the bit, from every facet at the side: it
   is computed from the end with the lower number. Returns the link, null if it is out of reach. */
static demi_link *demi_link_add(demi_ring *ring, dem_real within, int32_t number, const dem_vec3 *a,
                                const dem_vec3 *b, const int32_t *ends) {
    demi_link *to = ring->link + ring->links;
    const int turn = b && ends[0] > ends[1];
    int where = 4;
    to->point = b ? demi_side_point(turn ? *b : *a, turn ? *a : *b, 0, 1, &where) : *a;
    to->distance = demi_length(to->point);
    if (!(to->distance < within)) return 0;
    to->middle = b ? demi_scale(demi_add(*a, *b), DEM_R(0.5)) : *a;
    to->corner = !b;
    to->facet = ring->facets;
    to->number = number;
    to->place = !b || where < 4 ? number : ends[turn ? 5 - where : where - 4];
    to->sides[0] = to->sides[1] = -1;
    ring->links++;
    return to;
}
/* Adds element e with its sides and corners, if it is within reach. */
static void demi_links_add(const demi_wall *wall, int e, dem_vec3 x, const demi_part *part,
                           dem_real within, demi_ring *ring) {
    const int faces = ring->offset, edges = faces + wall->element_count;
    const int corners = edges + wall->edge_count;
    const int32_t *v;
    dem_vec3 y[3], d;
    int k, n, where;
    dem_real l;
    if (!(wall->weight[e] > 0)) return;
    n = demi_facet_seen(wall, e, x, part, y);
    v = wall->corners + n*e;
    d = demi_facet_point(y, n, &where);
    l = demi_length(d);
    if (!(l < within)) return;
    if (!ring->facets || l < ring->distance) {
        ring->number = where == 0 ? faces + e : where < 4 ? edges + wall->edges[3*e + where - 1]
            : corners + v[where - 4];
        ring->distance = l;
        ring->point = d;
    }
    for (k = 0; k < n; k++) {
        const int b = (k + 1)%n;
        int32_t ends[2];
        demi_link *corner = demi_link_add(ring, within, corners + v[k], y + k, 0, 0);
        ends[0] = corners + v[k];
        ends[1] = corners + v[b];
        if (n < 3) continue;
        if (corner) {
            corner->sides[0] = edges + wall->edges[3*e + k];
            corner->sides[1] = edges + wall->edges[3*e + (k + 2)%3];
        }
        demi_link_add(ring, within, edges + wall->edges[3*e + k], y + k, y + b, ends);
    }
    ring->facets++;
}
/* Orders links by `more`, then as above. */
static int demi_link_along(const void *x, const void *y) {
    const demi_link *a = (const demi_link *)x, *b = (const demi_link *)y;
    if (a->more < b->more) return -1;
    return a->more > b->more ? 1 : demi_link_compare(x, y);
}
/* Gives a side or corner that several images of the surface share, where one continues the other,
   the number that it has in the first of them. numbers: those of one image. Links in one place are
   found next to each other in the order of a coordinate in which few others agree. */
static void demi_links_share(demi_ring *ring, int numbers, dem_real near_by) {
    demi_link *link = ring->link;
    int i, k, s, way;
    for (i = 0; i < ring->links; i++)
        link[i].more = demi_dot(link[i].middle, demi_v(1, DEM_R(0.618034), DEM_R(0.236068)));
    qsort(link, (size_t)ring->links, sizeof *link, demi_link_along);
    for (i = 0; i < ring->links; i++) {
        int first = i;
        for (way = -1; way < 2; way += 2)
            for (k = i + way; k >= 0 && k < ring->links &&
                 DEMI_ABS(link[k].more - link[i].more) < 2*near_by; k += way) {
                const dem_vec3 d = demi_sub(link[k].middle, link[i].middle);
                if (link[k].corner == link[i].corner && demi_dot(d, d) <= near_by*near_by &&
                    link[k].place/numbers < link[first].place/numbers) first = k;
            }
        link[i].root = link[first].number;
    }
    for (i = 0; i < ring->links; i++) link[i].more = (dem_real)link[i].facet;
    qsort(link, (size_t)ring->links, sizeof *link, demi_link_along);
    for (i = 0; i < ring->links; i++) {
        const int32_t was = link[i].number, now = link[i].root;
        for (k = DEMI_MAX(i - 5, 0); k < ring->links && k < i + 6; k++)    /* a facet has six */
            for (s = 0; s < 2 && link[k].facet == link[i].facet && now != was; s++)
                if (link[k].sides[s] == was) link[k].sides[s] = now;
        link[i].number = now;
    }
}
/* Returns the weight of a corner in chi, from the facets at it (links first .. end - 1): 1 + facets
   - sides for meshes, 1 - facets for profiles. */
static int demi_links_corner(const demi_link *link, int first, int end) {
    int i, k, j, sides = 0;
    if (link[first].sides[0] < 0) return 1 - (end - first);
    for (i = first; i < end; i++)
        for (k = 0; k < 2; k++) {
            int seen = 0;
            for (j = first; j < i && !seen; j++)
                seen = link[j].sides[0] == link[i].sides[k] || link[j].sides[1] == link[i].sides[k];
            sides += !seen;
        }
    return 1 + (end - first) - sides;
}
/* Corrects the contact points of one body and wall for open rings. power: exponent of
   U(overlap). */
static void demi_places_rings(const demi_ring *ring, dem_real within, dem_real power,
                              demi_places *p) {
    demi_link *link = ring->link;
    const int count = ring->links;
    dem_real lost = 0, t, h, slope;
    int i, k, end;
    if (ring->facets < 2) return;
    qsort(link, (size_t)count, sizeof *link, demi_link_compare);
    for (i = 1; i < count; i++)                 /* one distance per side, despite rounding */
        if (link[i].number == link[i - 1].number) link[i].distance = link[i - 1].distance;
    qsort(link, (size_t)count, sizeof *link, demi_link_nearer);
    for (i = 0; i < ring->facets; i++) link[i].root = i;
    for (i = 0; i < count; i = end) {
        const dem_real q = (within - link[i].distance)/(within - ring->distance);
        int joined = 0;
        for (end = i + 1; end < count && link[end].number == link[i].number; end++) {
            const int a = demi_link_root(link, link[i].facet);
            const int b = demi_link_root(link, link[end].facet);
            joined += a != b;
            link[DEMI_MAX(a, b)].root = DEMI_MIN(a, b);
        }
        k = link[i].corner ? -demi_links_corner(link, i, end) : end - i - 1;
        link[i].more = (dem_real)(k - joined);
        lost += link[i].more*(power > 2 ? q*q*DEMI_SQRT(q) : q*q);
        for (k = i + 1; k < end; k++) link[k].more = 0;
    }
    if (!(lost > DEM_R(0.25))) return;
    t = DEMI_MIN(2*lost - DEM_R(0.5), DEM_R(1));
    h = t*t*(3 - 2*t);
    p->offset = 0;                              /* links have theirs in their numbers */
    slope = t < 1 ? 12*t*(1 - t) : 0;           /* dh/dq */
    for (i = 0; i < count; i++)
        if (link[i].more < 0 || link[i].more > 0)
            demi_places_add(p, link[i].place, link[i].more*(h + lost*slope), link[i].point,
                       link[i].distance*link[i].distance);
    demi_places_add(p, ring->number, -lost*lost*slope, ring->point, ring->distance*ring->distance);
}

/* --- sieves: a sphere against a whole sieve, in the sieve's frame: z across the sheet, the middle
   of a hole at x = y = 0, wires and holes in rows along x and y. Only nearby wires or holes are
   examined, found from the sphere's position; the cost does not depend on the number of holes.
         rows    wires, bars, and the strips between square holes or slots: convex, infinite or cut
                 off by a disc. Rows of set 0 run along y, those of set 1 along x
         round   plates with round holes: the face, or the nearest point of the rim and the opposite
                 one, so that a grain too large for the hole rests on it
         ring    plates and reduced holes cut out as a disc lie in a thin ring
   Where two rows cross, a grain that reaches both at the same point touches one body. With d the
   distances of rows and of their crossings (what two rows share), and U(d) the energy of a contact
   of overlap r - d,
           E = sum of U(rows) - sum of U(those crossings that join, nearest first, what was not
               joined yet)
   This sums over the separate pieces within reach as the reach grows (Kruskal's forest, as for
   rings of facets). E is never below that of the nearest row, and the force is its gradient, so
   energy is conserved; a plate repels as one body however fine its holes. A crossing at a row's own
   nearest point cancels that row: above a crossing there is one contact, half way between two rows
   there are two. Any other crossing is a contact of its own with share -1. Each row, crossing and
   side has its own element number for the contact history. Tests: tests/surface/test_sieve.c,
   tests/hard/hard_impacts.c. --- */
enum { DEMI_SIEVE_FACE = 1 << 30, DEMI_SIEVE_RIM = DEMI_SIEVE_FACE + 1,
       DEMI_SIEVE_ROWS = 13 };                  /* rows of both sets, and the ring */
/* The last three bits of a row's number; for round holes they are 0 .. 5: side, lattice. */
enum { DEMI_SIEVE_SET = 1, DEMI_SIEVE_ABOVE = 2, DEMI_SIEVE_CROSS = 4 };
/* A row of a sieve (wire, bar, strip or ring) that a sphere reaches. */
typedef struct demi_sieve_row {
    int32_t number;
    int set, root;                 /* set 2: the ring; root: in the forest */
    double i;                      /* its index within its set */
    dem_real at, half;             /* m, its middle; half its width */
    dem_real distance, edge;       /* m, from the sphere's centre; radius around foot */
    dem_vec3 foot;                 /* m, nearest point, of the axis for a wire */
} demi_sieve_row;
/* A crossing of rows a and b: its nearest point and the distance of that, m. */
typedef struct demi_sieve_shared { dem_real distance; int a, b; dem_vec3 foot; } demi_sieve_shared;

/* Element number of a row or hole. Distant ones share numbers, which does no harm. */
static int32_t demi_sieve_number(double i, double j, int side) {
    const int32_t a = (int32_t)(i - floor(i/16384)*16384), b = (int32_t)(j - floor(j/8192)*8192);
    return (int32_t)(((uint32_t)a << 16) | ((uint32_t)b << 3) | (uint32_t)side);
}
/* Adds the contact with the ball of radius `edge` around foot, if they overlap. Returns the new
   count. */
static int demi_sieve_put(demi_touching *out, int count, int32_t element, dem_vec3 x,
                          dem_real r, dem_vec3 foot, dem_real edge) {
    const dem_vec3 d = demi_sub(foot, x);
    const dem_real l = demi_length(d), overlap = r + edge - l;
    demi_touching *c = &out[count];
    if (!(overlap > 0) || count == DEMI_SIEVE_MOST) return count;
    c->element = element;
    c->normal = l > 0 ? demi_scale(d, 1/l) : demi_v(0, 0, -1);
    c->point = demi_add(x, demi_scale(c->normal, l - edge));
    c->overlap = overlap;
    c->share = 1;
    return count + 1;
}
/* The contact with the sieve as a plate without holes. Returns 1 if there is one. */
static int demi_sieve_face(const dem_sieve_desc *s, dem_vec3 x, dem_real r, demi_touching *out) {
    const dem_real up = x.z >= 0 ? DEM_R(1) : DEM_R(-1);
    out->element = DEMI_SIEVE_FACE;
    out->normal = demi_v(0, 0, -up);
    out->point = demi_v(x.x, x.y, up*s->thickness/2);
    out->overlap = r + s->thickness/2 - up*x.z;
    out->share = 1;
    return out->overlap > 0;
}
DEM_INLINE dem_real demi_clamp(dem_real x, dem_real lo, dem_real hi) {
    return x < lo ? lo : x > hi ? hi : x;
}
/* Moves (*u, *v) to the nearest point of a strip, at - half .. at + half across u, cut off by a
   disc of radius R (0: not cut off). Returns 0 if there is no such point. */
static int demi_strip_point(dem_real at, dem_real half, dem_real R, dem_real *u, dem_real *v) {
    const dem_real x = *u, y = *v, lo = at - half, hi = at + half;
    const dem_real S = DEMI_SQRT(x*x + y*y), within = demi_clamp(x, lo, hi);
    dem_real best = -1;
    int k;
    *u = within;
    if (!(R > 0) || within*within + y*y <= R*R) return 1;
    *u = x*R/S; *v = y*R/S;                     /* on the disc's edge, if within the strip */
    if (S > R && *u >= lo && *u <= hi) return 1;
    for (k = 0; k < 2; k++) {                   /* a corner, where the strip's side ends */
        const dem_real side = k ? hi : lo, long2 = R*R - side*side;
        const dem_real end = long2 > 0 ? DEMI_SQRT(long2) : 0, to = demi_clamp(y, -end, end);
        const dem_real d2 = (side - x)*(side - x) + (to - y)*(to - y);
        if (!(long2 > 0) || (best >= 0 && d2 >= best)) continue;
        best = d2; *u = side; *v = to;
    }
    return best >= 0;
}
/* Adds the rows of one set that a sphere reaches. Returns the new count. */
static int demi_sieve_set(const dem_sieve_desc *s, int set, dem_vec3 x, dem_real r,
                          demi_sieve_row *row, int count) {
    const int wires = demi_sieve_wires(s);
    const dem_real q = s->bar/2, h = !wires ? 0 : set ? -s->lift/2 : s->lift/2, R = s->radius;
    const dem_real hole = !set && s->kind == DEM_SIEVE_SLOTS ? s->length : s->aperture;
    const dem_real pitch = hole + s->bar, half = wires ? 0 : s->thickness/2;
    const dem_real u = set ? x.y : x.x, v = set ? x.x : x.y, S = DEMI_SQRT(x.x*x.x + x.y*x.y);
    const dem_real z = wires ? h : demi_clamp(x.z, -half, half);
    const dem_real far2 = (r + q)*(r + q) - (x.z - z)*(x.z - z);
    const double home = floor((double)((R > 0 && S > R ? u*R/S : u)/pitch));
    int k;
    if (!(far2 > 0) || !(hole > 0)) return count;
    for (k = -2; k <= 3; k++) {                 /* enough: a far larger grain rests on these */
        demi_sieve_row *one = &row[count];
        const dem_real at = (dem_real)(home + k + 0.5)*pitch, off = u - at;
        dem_real a = u, b = v;
        dem_vec3 d;
        if (off*off >= far2 + 2*q*(r + q) + q*q ||
            !demi_strip_point(at, wires ? DEM_R(0) : q, R, &a, &b)) continue;
        one->foot = set ? demi_v(b, a, z) : demi_v(a, b, z);
        d = demi_sub(one->foot, x);
        one->edge = wires ? q : 0;
        one->distance = demi_length(d) - one->edge;
        if (!(one->distance < r)) continue;
        one->set = set;
        one->i = home + k;
        one->at = at;
        one->half = q;
        one->number = demi_sieve_number(home + k, 0, set | (!wires && !(d.x < 0 || d.x > 0) &&
                                        !(d.y < 0 || d.y > 0) ? DEMI_SIEVE_ABOVE : 0));
        count++;
    }
    return count;
}
/* Returns the point nearest to p, outside both, of the intersection of two wires, X^2 + (Z - h)^2
   <= q^2 and Y^2 + (Z + h)^2 <= q^2. It is p moved towards both axes until it is on both surfaces:
   Newton's method for the two multipliers. */
static dem_vec3 demi_wires_point(dem_vec3 p, dem_real q, dem_real h) {
    double m = sqrt((double)(p.x*p.x + (p.z - h)*(p.z - h)))/(double)q - 1;
    double n = sqrt((double)(p.y*p.y + (p.z + h)*(p.z + h)))/(double)q - 1;
    const double q2 = (double)q*(double)q, H = (double)h;
    double x = 0, y = 0, z = 0;
    int k;
    for (k = 0; k < 40; k++) {
        double sum, g, f, gm, gn, fn, det, dm, dn;
        sum = 1 + m + n;
        x = (double)p.x/(1 + m); y = (double)p.y/(1 + n);
        z = ((double)p.z + (m - n)*H)/sum;
        g = x*x + (z - H)*(z - H) - q2;
        f = y*y + (z + H)*(z + H) - q2;
        if (fabs(g) + fabs(f) < (DEMI_SINGLE ? 1e-12 : 4e-16)*q2) break;
        gm = -2*(x*x/(1 + m) + (z - H)*(z - H)/sum);
        fn = -2*(y*y/(1 + n) + (z + H)*(z + H)/sum);
        gn = -2*(z - H)*(z + H)/sum;
        det = gm*fn - gn*gn;
        if (!(det > 0)) break;
        dm = (-g*fn + f*gn)/det;
        dn = (-f*gm + g*gn)/det;
        m = m + dm > m/4 ? m + dm : m/4;
        n = n + dn > n/4 ? n + dn : n/4;
    }
    return demi_v((dem_real)x, (dem_real)y, (dem_real)z);
}
/* Finds the nearest point of the crossing of rows a and b (a of set 0 or 1, b of a later one).
   Returns 2 if it is a's own nearest point, 3 if it is b's, otherwise 1; 0: they do not cross. */
static int demi_sieve_crossing(const dem_sieve_desc *s, const demi_sieve_row *a,
                               const demi_sieve_row *b, dem_vec3 x, dem_vec3 *foot) {
    const dem_real R = s->radius, half = s->thickness/2;
    const dem_real u = a->set ? x.y : x.x, v = a->set ? x.x : x.y;
    dem_real S, best = -1;
    int k;
    if (a->set == b->set) return 0;
    if (b->set == 2) {                          /* the ring, between the strip's sides */
        foot->z = demi_clamp(x.z, -half, half);
        S = DEMI_SQRT(u*u + v*v);
        for (k = 0; k < 5; k++) {
            const dem_real p = k == 4 ? u*R/S : a->at + (k & 1 ? a->half : -a->half);
            const dem_real far = R*R - p*p;
            const dem_real w = k == 4 ? v*R/S : !(far > 0) ? 0 : k & 2 ? DEMI_SQRT(far)
                : -DEMI_SQRT(far);
            const dem_real d2 = (p - u)*(p - u) + (w - v)*(w - v);
            if (k == 4 ? DEMI_ABS(p - a->at) > a->half : !(far > 0)) continue;
            if (best >= 0 && d2 >= best) continue;
            best = d2;
            foot->x = a->set ? w : p;
            foot->y = a->set ? p : w;
        }
        return best >= 0;
    }
    if (R > 0 && a->at*a->at + b->at*b->at >= R*R) return 0;
    if (s->kind == DEM_SIEVE_WIRES) {
        const dem_real q = s->bar/2, h = s->lift/2;
        const dem_vec3 at = demi_v(a->at, b->at, 0), p = demi_sub(x, at);
        const dem_vec3 f = demi_sub(demi_add(x, demi_scale(demi_sub(a->foot, x), a->distance/
                              (a->distance + q))), at);      /* nearest point of a: inside b too? */
        const dem_vec3 g = demi_sub(demi_add(x, demi_scale(demi_sub(b->foot, x), b->distance/
                              (b->distance + q))), at);
        const int in_b = f.y*f.y + (f.z + h)*(f.z + h) <= q*q;
        const int in_a = g.x*g.x + (g.z - h)*(g.z - h) <= q*q;
        if (h >= q) return 0;
        *foot = demi_add(at, in_b ? f : in_a ? g : demi_wires_point(p, q, h));
        return in_b ? 2 : in_a ? 3 : 1;
    }
    *foot = demi_v(demi_clamp(x.x, a->at - a->half, a->at + a->half),
                   demi_clamp(x.y, b->at - b->half, b->at + b->half),
                   demi_clamp(x.z, -half, half));
    return 1;
}
static int demi_sieve_root(demi_sieve_row *row, int i) {
    while (row[i].root != i) i = row[i].root;
    return i;
}
/* Contacts with rows, less their crossings, as above. Returns their number. */
static int demi_sieve_rows(const dem_sieve_desc *s, dem_vec3 x, dem_real r, demi_touching *out) {
    demi_sieve_row row[DEMI_SIEVE_ROWS];
    demi_sieve_shared all[DEMI_SIEVE_ROWS*DEMI_SIEVE_ROWS/2];
    const dem_real half = s->thickness/2, S = DEMI_SQRT(x.x*x.x + x.y*x.y);
    int rows = demi_sieve_set(s, 0, x, r, row, 0), i, k, crossings = 0, count = 0;
    if (s->kind != DEM_SIEVE_BARS) rows = demi_sieve_set(s, 1, x, r, row, rows);
    if (!demi_sieve_wires(s) && s->radius > 0 && S > 0) {
        demi_sieve_row *ring = &row[rows];
        memset(ring, 0, sizeof *ring);
        ring->foot = demi_v(x.x*s->radius/S, x.y*s->radius/S, demi_clamp(x.z, -half, half));
        ring->distance = demi_length(demi_sub(ring->foot, x));
        ring->set = 2;
        ring->number = DEMI_SIEVE_RIM;
        rows += ring->distance < r;
    }
    for (i = 0; i < rows; i++) {
        row[i].root = i;
        for (k = 0; k < i; k++) {
            demi_sieve_shared one;
            const int how = demi_sieve_crossing(s, &row[k], &row[i], x, &one.foot);
            one.a = k; one.b = i;
            if (!how) continue;
            one.distance = how == 1 ? demi_length(demi_sub(one.foot, x))
                : row[how == 2 ? k : i].distance;
            if (!(one.distance < r)) continue;
            all[crossings++] = one;
        }
    }
    for (; crossings > 0; all[i] = all[--crossings]) {    /* nearest first */
        int a, b, at;
        for (i = 0, k = 1; k < crossings; k++) if (all[k].distance < all[i].distance) i = k;
        a = demi_sieve_root(row, all[i].a);
        b = demi_sieve_root(row, all[i].b);
        if (a == b) continue;
        row[DEMI_MAX(a, b)].root = DEMI_MIN(a, b);
        a = all[i].a; b = all[i].b;
        at = row[a].distance > row[b].distance ? a : b;
        if (all[i].distance <= row[at].distance && !(row[at].edge < 0))
            row[at].edge = -1;                  /* the row's own nearest point: they cancel */
        else {
            k = count;
            count = demi_sieve_put(out, count, row[b].set == 2 ? DEMI_SIEVE_RIM + 1 :
                                   demi_sieve_number(row[a].i, row[b].i, DEMI_SIEVE_CROSS), x, r,
                                   all[i].foot, 0);
            if (count > k) out[k].share = -1;
        }
    }
    for (i = 0; i < rows; i++) {
        if (row[i].edge < 0) continue;
        if (!(row[i].distance > 0) && half > 0 && !demi_sieve_wires(s)) {
            /* within the plate: out by the nearer face */
            count += demi_sieve_face(s, x, r, out + count);
            out[count - 1].element = row[i].number;
        } else count = demi_sieve_put(out, count, row[i].number, x, r, row[i].foot, row[i].edge);
    }
    return count;
}
/* Contacts with a plate with round holes: the nearest and the opposite point on the rim of the hole
   below the centre; over a bar, the plate. */
static int demi_sieve_round(const dem_sieve_desc *s, dem_vec3 x, dem_real r, demi_touching *out) {
    const dem_real half = s->thickness/2, z = demi_clamp(x.z, -half, half);
    const dem_real a = s->aperture/2, R = s->radius, S = DEMI_SQRT(x.x*x.x + x.y*x.y);
    dem_real best, l;
    dem_vec3 way, centre = x, to;
    double at[2] = {0, 0};
    int32_t number;
    int other = 0, side, count = 0;
    if (R > 0 && S > 0 && S > R - r)
        count = demi_sieve_put(out, 0, DEMI_SIEVE_RIM, x, r, demi_v(x.x*R/S, x.y*R/S, z), 0);
    if (R > 0 && S > R) return count;           /* beyond the disc */
    best = demi_round_hole(s, x, &centre, at, &other);
    number = demi_sieve_number(at[0], at[1], 4*other);
    if (best >= a*a) return demi_sieve_face(s, x, r, out);
    l = DEMI_SQRT(best);
    way = l > 0 ? demi_v((x.x - centre.x)/l, (x.y - centre.y)/l, 0) : demi_v(1, 0, 0);
    for (side = 0; side < 2; side++) {          /* nearest, opposite */
        to = demi_add(demi_v(centre.x, centre.y, z), demi_scale(way, side ? -a : a));
        if (R > 0 && to.x*to.x + to.y*to.y > R*R) continue;
        count = demi_sieve_put(out, count, number + side, x, r, to, 0);
    }
    return count;
}
/* Weights of contacts that are really one, where rims come together. Each counts by how far its
   point projects, towards the grain, beyond the tangent plane at the other. L_a: how far a's point
   projects beyond b's plane.
       share_a = max(L_a/(L_a + L_b), min(1, L_a/overlap_a))
   Half way between the two each bears half; if L is far larger than the overlap, each bears all.
   The transition has no jump. */
static void demi_sieve_share(demi_touching *c, int count, dem_real range) {
    int a, b;
    for (a = 0; a < count; a++)
        for (b = a + 1; b < count; b++) {
            const dem_vec3 d = demi_sub(c[b].point, c[a].point);
            dem_real la = demi_dot(c[b].normal, d), lb = -demi_dot(c[a].normal, d), sa, sb;
            la = la > 0 ? la : 0;
            lb = lb > 0 ? lb : 0;
            sa = la + lb > 0 ? la/(la + lb) : 1;
            sb = 1 - sa;
            la /= DEMI_MAX(c[a].overlap - range, DEMI_TINY);    /* if apart: weight 1 */
            lb /= DEMI_MAX(c[b].overlap - range, DEMI_TINY);
            c[a].share *= DEMI_MAX(sa, DEMI_MIN(la, DEM_R(1)));
            c[b].share *= DEMI_MAX(sb, DEMI_MIN(lb, DEM_R(1)));
        }
}
/* [ALK07] eqs. 4.20 to 4.25: 1 if a grain over (x, y) falls through. Half a hole is w; the reduced
   one is w - b, with b = zeta (w - r) or zeta w. Model 1 requires the grain's edge within it, model
   2 its centre and r < w. [ALK07] leaves open what "c_x" does for grains that fit in no hole: here
   they never fall. */
static int demi_sieve_passes(const dem_sieve_desc *s, dem_vec3 x, dem_real r) {
    const dem_real w = s->aperture/2, pitch = s->aperture + s->bar;
    const dem_real room = (1 - s->clearance)*(s->model == 2 ? w : w - r);
    const dem_real u = x.x - (dem_real)floor((double)(x.x/pitch) + 0.5)*pitch;
    const dem_real v = x.y - (dem_real)floor((double)(x.y/pitch) + 0.5)*pitch;
    return r < w && DEMI_ABS(u) < room && DEMI_ABS(v) < room;
}
/* Finds all contacts of a sphere at x with a sieve: at most DEMI_SIEVE_MOST; the caller fills in
   body and wall. r: its radius plus the range of a law; overlaps above `range` are real. A contact
   of share 0 has no force: the grain is on its way through a reduced hole. */
static int demi_sieve_touch(const dem_sieve_desc *s, dem_vec3 x, dem_real r, dem_real range,
                            demi_touching *out) {
    const dem_real S = DEMI_SQRT(x.x*x.x + x.y*x.y);
    int count = 0;
    switch (s->kind) {
    case DEM_SIEVE_REDUCED:
        if (s->radius > 0 && S > s->radius)
            return demi_sieve_put(out, 0, DEMI_SIEVE_RIM, x, r,
                                  demi_v(x.x*s->radius/S, x.y*s->radius/S, 0), 0);
        count = demi_sieve_face(s, x, r, out);
        if (count && demi_sieve_passes(s, x, r - range)) out->share = 0;
        return count;
    case DEM_SIEVE_ROUND:
        count = demi_sieve_round(s, x, r, out);
        if (count > 1) demi_sieve_share(out, count, range);
        break;
    default: count = demi_sieve_rows(s, x, r, out);
    }
    return count;
}

/* [MIL] Fig 5.19: the segment acts like its infinite line, with the fraction a^2(3-2a) of the
   force, where a is the fraction of the chord that the segment covers. Returns that fraction. */
static dem_real demi_segment_share(const demi_wall *wall, int element, dem_vec3 x, dem_real r,
                                   dem_vec3 *normal,
                                   dem_vec3 *point, dem_real *overlap) {
    dem_vec3 c[2], t, n;
    dem_real length, off, along, chord, lo, hi, a;
    demi_wall_corners(wall, element, c);
    t = demi_sub(c[1], c[0]);
    length = demi_length(t);
    if (!(length > 0)) return 0;
    t = demi_scale(t, 1/length);
    n = demi_v(-t.y, t.x, 0);
    x.z = 0;
    off = demi_dot(demi_sub(x, c[0]), n);       /* signed distance from the line */
    along = demi_dot(demi_sub(x, c[0]), t);
    if (DEMI_ABS(off) >= r) return 0;
    chord = DEMI_SQRT(r*r - off*off);
    lo = DEMI_MAX(along - chord, DEM_R(0));
    hi = DEMI_MIN(along + chord, length);
    if (hi <= lo) return 0;
    a = (hi - lo)/(2*chord);
    *normal = off > 0 ? demi_scale(n, -1) : n;
    *point = demi_add(c[0], demi_scale(t, along));
    *overlap = r - DEMI_ABS(off);
    return a*a*(3 - 2*a);
}

#if defined(__GNUC__) && !defined(__clang__) && !defined(__TINYC__)
#pragma GCC push_options
#pragma GCC optimize("no-trapping-math")
#endif
