/* ---------------------------------------------------------------------------------------------
   >>outlines
   Triangulation of polygonal faces by ear clipping. The triangles keep the winding of the face. The
   face's normal is Newell's (a sum of cross products over its edges), and the corners are projected
   along the coordinate axis that is nearest to it. A convex face becomes a fan from its first
   corner. From any other face, ears are cut off one by one: an ear is a corner whose triangle lies
   inside the face. Holes that are bridged by an edge there and back, collinear corners and doubled
   corners are allowed. n corners always give n - 2 triangles; a doubled corner gives a triangle
   without area. This part owns demi_outline and needs a world only for memory.
   ---------------------------------------------------------------------------------------------- */
/* DEMI_OUTLINE_MOST: largest number of corners of a face that is not convex; every edge is tested
   against every other. DEMI_OUTLINE_CELLS: cells along a side of the square grid that finds the
   corners near an ear. */
enum { DEMI_OUTLINE_MOST = 10000, DEMI_OUTLINE_CELLS = 32 };
/* The face being cut. Corners are numbered 0 to count - 1 in the order of the outline. */
typedef struct demi_outline {
    int count;
    int32_t *corner;               /* index of each corner's vertex in the mesh */
    int32_t *next, *prev;          /* ring of the corners that are left; next is -1 once cut off */
    int32_t *beside;               /* next corner in the same cell of the grid; -1: none */
    int32_t first[DEMI_OUTLINE_CELLS*DEMI_OUTLINE_CELLS];  /* first corner in each cell; -1: none */
    double *xy;                    /* count x 2, m: projected, counterclockwise, corner 0 at 0 */
    double lo[2], cell;            /* m: lowest corner of the grid, size of a cell */
    double near;                   /* m2: a triangle has no area if twice that is at most this */
    double work;                   /* corners and cells that may still be visited */
    int bent, crossed;             /* 1: not flat; 1: an edge crosses another, or it has no area */
} demi_outline;
static void demi_outline_free(dem_world *w, demi_outline *o) {
    demi_free(w, o->corner);
    demi_free(w, o->next);
    demi_free(w, o->prev);
    demi_free(w, o->beside);
    demi_free(w, o->xy);
}
/* Makes room for one more corner. Returns 0 if memory ran out. */
static int demi_outline_grow(dem_world *w, demi_outline *o) {
    const size_t n = (size_t)o->count + 1;
    return demi_grow(w, DEMI_LOOSE, &o->corner, sizeof *o->corner, n) &&
        demi_grow(w, DEMI_LOOSE, &o->next, sizeof *o->next, n) &&
        demi_grow(w, DEMI_LOOSE, &o->prev, sizeof *o->prev, n) &&
        demi_grow(w, DEMI_LOOSE, &o->beside, sizeof *o->beside, n) &&
        demi_grow(w, DEMI_LOOSE, &o->xy, sizeof *o->xy, 2*n);
}
/* Returns twice the signed area of the triangle a, b, c (m2), positive if counterclockwise. */
static double demi_outline_turn(const demi_outline *o, int a, int b, int c) {
    return demi_turn_of(o->xy, a, b, c);
}
/* True if two corners have the same projected position. */
static int demi_outline_same(const demi_outline *o, int a, int b) {
    return !(o->xy[2*a] < o->xy[2*b] || o->xy[2*a] > o->xy[2*b] ||
             o->xy[2*a + 1] < o->xy[2*b + 1] || o->xy[2*a + 1] > o->xy[2*b + 1]);
}
/* Projects the corners to `xy` and links them to a ring. Sets `crossed` if the face has no area,
   and `bent` if a corner is farther from the mean plane than 1e-3 of the face's largest extent. */
static void demi_outline_lay(demi_outline *o, const dem_real *vertices) {
    const demi_d3 first = demi_d3_of(demi_at(vertices + 3*o->corner[0]));
    demi_d3 n = demi_d(0, 0, 0), mean = n, lo = n, hi = n;
    double far = 0, length, size, x[3];
    int i, back, axis = 0;
    for (i = 0; i < o->count; i++) {
        const demi_d3 p = demi_d3_sub(demi_d3_of(demi_at(vertices + 3*o->corner[i])), first);
        const int32_t next = o->corner[(i + 1)%o->count];
        n = demi_d3_add(n, demi_d3_cross(p, demi_d3_sub(demi_d3_of(demi_at(vertices + 3*next)),
                                                        first)));
        mean = demi_d3_add(mean, demi_d3_over(p, o->count));
        lo = demi_d3_lowest(lo, p);
        hi = demi_d3_highest(hi, p);
    }
    size = DEMI_MAX(hi.x - lo.x, DEMI_MAX(hi.y - lo.y, hi.z - lo.z));
    demi_d3_put(x, n);
    for (i = 1; i < 3; i++) if (fabs(x[i]) > fabs(x[axis])) axis = i;
    back = x[axis] < 0;
    length = demi_d3_length(n);
    o->near = 1e-10*size*size;
    o->bent = 0;
    o->crossed = !(length > o->near);
    for (i = 0; i < o->count; i++) {
        const demi_d3 p = demi_d3_sub(demi_d3_of(demi_at(vertices + 3*o->corner[i])), first);
        far = DEMI_MAX(far, fabs(demi_d3_dot(n, demi_d3_sub(p, mean))));
        demi_d3_put(x, p);
        o->xy[2*i] = x[back ? (axis + 2)%3 : (axis + 1)%3];
        o->xy[2*i + 1] = x[back ? (axis + 1)%3 : (axis + 2)%3];
        o->next[i] = (i + 1)%o->count;
        o->prev[i] = (i + o->count - 1)%o->count;
    }
    if (!o->crossed) o->bent = far > 1e-3*size*length;
}
/* True if the outline turns left at every corner and goes round once. A pentagram turns left at
   every corner, too, but goes round twice. */
static int demi_outline_convex(const demi_outline *o) {
    int i, turns = 0;
    double last = 0;
    for (i = 0; i < o->count; i++) {
        const double along = o->xy[2*o->next[i]] - o->xy[2*i];
        if (!(demi_outline_turn(o, o->prev[i], i, o->next[i]) > o->near)) return 0;
        turns += along*last < 0;
        if (along < 0 || along > 0) last = along < 0 ? -1 : 1;
    }
    return turns <= 2;
}
/* True if two edges cross at a point that is a corner of neither. */
static int demi_outline_crosses(const demi_outline *o) {
    int i, j;
    for (i = 0; i < o->count; i++)
        for (j = i + 2; j < o->count; j++) {
            const int k = (i + 1)%o->count, l = (j + 1)%o->count;
            const double a = demi_outline_turn(o, i, k, j), b = demi_outline_turn(o, i, k, l);
            if (!((a > o->near && b < -o->near) || (a < -o->near && b > o->near))) continue;
            const double c = demi_outline_turn(o, j, l, i), d = demi_outline_turn(o, j, l, k);
            if ((c > o->near && d < -o->near) || (c < -o->near && d > o->near)) return 1;
        }
    return 0;
}
/* Returns the number of the cell along an axis that contains coordinate x (m), at most the last. */
static int demi_outline_cell(const demi_outline *o, double x, int axis) {
    const double at = (x - o->lo[axis])/o->cell;
    return at > 0 ? (int)DEMI_MIN(at, DEMI_OUTLINE_CELLS - 1) : 0;
}
/* Sets up the grid and enters all corners in their cells. */
static void demi_outline_sort(demi_outline *o) {
    double size = 0;
    int i, k;
    for (k = 0; k < 2; k++) {
        double hi = o->lo[k] = o->xy[k];
        for (i = 1; i < o->count; i++) {
            o->lo[k] = DEMI_MIN(o->lo[k], o->xy[2*i + k]);
            hi = DEMI_MAX(hi, o->xy[2*i + k]);
        }
        size = DEMI_MAX(size, hi - o->lo[k]);
    }
    o->cell = size/(int)DEMI_OUTLINE_CELLS;
    for (i = 0; i < DEMI_OUTLINE_CELLS*DEMI_OUTLINE_CELLS; i++) o->first[i] = -1;
    for (i = 0; i < o->count; i++) {
        int32_t *first = o->first + demi_outline_cell(o, o->xy[2*i], 0) +
            (int)DEMI_OUTLINE_CELLS*demi_outline_cell(o, o->xy[2*i + 1], 1);
        o->beside[i] = *first;
        *first = i;
    }
}
/* True if corner q prevents corner i from being cut off. It does if it lies inside the triangle of
   i, which means that twice the area it spans with each side is above `margin` (m2). It also does
   if it coincides with i and an edge of the outline leads from there into the triangle. */
static int demi_outline_blocks(const demi_outline *o, int q, int i, double margin) {
    const int a = o->prev[i], b = o->next[i], out[2] = {o->prev[q], o->next[q]};
    int k;
    if (q == i || demi_outline_same(o, q, a) || demi_outline_same(o, q, b)) return 0;
    if (!demi_outline_same(o, q, i))
        return demi_outline_turn(o, a, i, q) > margin && demi_outline_turn(o, i, b, q) > margin &&
            demi_outline_turn(o, b, a, q) > margin;
    for (k = 0; k < 2; k++)
        if (demi_outline_turn(o, a, i, out[k]) > o->near &&
            demi_outline_turn(o, i, b, out[k]) > o->near) return 1;
    return 0;
}
/* True if corner i may be cut off. With patience 0 its triangle must have an area, and no other
   corner may lie inside or on its sides. With patience 1 it may have no area, and no corner may lie
   inside. With patience 2 every corner may be cut off. A doubled corner always may. */
static int demi_outline_ear(demi_outline *o, int i, int patience) {
    const int corner[3] = {o->prev[i], i, o->next[i]};
    const double margin = patience ? o->near : -o->near;
    int from[2], to[2], k, x, y;
    if (patience > 1 || demi_outline_same(o, corner[0], i) ||
        demi_outline_same(o, i, corner[2])) return 1;
    if (!(demi_outline_turn(o, corner[0], i, corner[2]) > -margin)) return 0;
    for (k = 0; k < 2; k++) {
        const double p = o->xy[2*corner[0] + k], q = o->xy[2*i + k], r = o->xy[2*corner[2] + k];
        from[k] = demi_outline_cell(o, DEMI_MIN(p, DEMI_MIN(q, r)), k);
        to[k] = demi_outline_cell(o, DEMI_MAX(p, DEMI_MAX(q, r)), k);
    }
    for (y = from[1]; y <= to[1]; y++)
        for (x = from[0]; x <= to[0]; x++) {
            int32_t *q = o->first + x + (int)DEMI_OUTLINE_CELLS*y;
            for (o->work--; *q >= 0; o->work--) {
                if (o->next[*q] < 0) { *q = o->beside[*q]; continue; }
                if (demi_outline_blocks(o, *q, i, margin)) return 0;
                q = o->beside + *q;
            }
        }
    return 1;
}
/* Writes the count - 2 triangles of the face to `out`, three vertices of the mesh each. Sets `bent`
   and `crossed`. Returns 0 if the face is not convex and has too many corners. */
static int demi_outline_cut(demi_outline *o, const dem_real *vertices, int32_t *out) {
    int i, left = o->count, idle = 0, patience = 0;
    o->bent = o->crossed = 0;
    if (o->count > 3) demi_outline_lay(o, vertices);
    if (o->count == 3 || o->crossed || demi_outline_convex(o)) {
        for (i = 1; i + 1 < o->count; i++, out += 3) {
            out[0] = o->corner[0]; out[1] = o->corner[i]; out[2] = o->corner[i + 1];
        }
        return 1;
    }
    if (o->count > DEMI_OUTLINE_MOST) return 0;
    o->crossed = demi_outline_crosses(o);
    demi_outline_sort(o);
    o->work = 1e8;
    for (i = 0; left > 2;) {
        if (left == 3 || demi_outline_ear(o, i, patience)) {
            const int a = o->prev[i], b = o->next[i];
            o->crossed |= demi_outline_turn(o, a, i, b) < -o->near;
            out[0] = o->corner[a]; out[1] = o->corner[i]; out[2] = o->corner[b];
            out += 3;
            o->next[a] = b;
            o->prev[b] = a;
            o->next[i] = -1;
            left--;
            i = o->next[b];
            idle = patience = 0;
        } else {
            i = o->next[i];
            if (++idle >= left) { idle = 0; patience++; }
        }
        if (o->work < 0) patience = 2;          /* no sound outline takes this much work */
    }
    return 1;
}
