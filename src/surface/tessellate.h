/* ---------------------------------------------------------------------------------------------
   >>tessellate
   Curved walls and sieves as surfaces of facets, for bodies that have no closed form with them:
   polyhedra with cylinders and surfaces of revolution by springs, ellipsoids with sieves and
   surfaces of revolution. Other bodies keep their closed forms. The kind's function (TESSELLATE in
   DEMI_WALLS) makes the facets, which stand still in the wall's frame and are used as those of any
   mesh or profile (>>facets, >>touch, >>polyhedra-walls).

   Let s be the largest power of two, in m, below the radius of the body's bounding sphere. Facets
   deviate from the curve by at most 5e-4 s, for walls up to 20,000 times as large as s. Other
   bodies do not change them. A circle becomes a polygon of equal area with 24, 48, 96, ... 12,288
   sides. Smaller circles of a surface of revolution get fewer sides.

   A sieve without end is one cell, which repeats along two steps in its plane. Not tessellated:
   reduced holes, which [ALK07] defines for spheres, and sieves cut from a disc.
   --------------------------------------------------------------------------------------------- */

/* A tessellation while it is made. Points and facets are appended; `failed` is set if memory ran
   out. */
typedef struct demi_draft {
    dem_world *w;
    int per, points, facets, failed;           /* per: corners of a facet, 3 or 2 (>>layout) */
    dem_real *x;                   /* points x 3, m, in the wall's frame */
    int32_t *corner;               /* facets x per */
    double chord;                  /* m, largest distance from curves */
    dem_vec3 step[2];              /* m, in the wall's frame: the surface repeats; 0: it does not */
} demi_draft;
typedef void (*demi_tessellate_fn)(const demi_wall *wall, demi_draft *draft);
static int32_t demi_draft_point(demi_draft *f, double x, double y, double z) {
    if (!demi_grow(f->w, DEMI_LOOSE, &f->x, sizeof(dem_real), 3*((size_t)f->points + 1))) {
        f->failed = 1;
        return 0;
    }
    demi_put(f->x + 3*f->points, demi_v((dem_real)x, (dem_real)y, (dem_real)z));
    return f->points++;
}
/* Adds a triangle, or (per 2) the segment from a to b. */
static void demi_draft_facet(demi_draft *f, int32_t a, int32_t b, int32_t c) {
    const int32_t all[3] = {a, b, c};
    if (f->failed || !demi_grow(f->w, DEMI_LOOSE, &f->corner, sizeof(int32_t),
                                (size_t)f->per*((size_t)f->facets + 1))) f->failed = 1;
    else memcpy(f->corner + f->per*f->facets++, all, (size_t)f->per*sizeof *all);
}
static void demi_draft_quad(demi_draft *f, int32_t a, int32_t b, int32_t c, int32_t d) {
    demi_draft_facet(f, a, b, c);
    demi_draft_facet(f, a, c, d);
}
static void demi_draft_free(demi_draft *f) {
    demi_free(f->w, f->x);
    demi_free(f->w, f->corner);
}
/* The number of sides of a circle of radius r. */
enum { DEMI_FORM_LEAST = 24, DEMI_FORM_MOST = 12288 };
static int demi_draft_sides(const demi_draft *f, double r) {
    int n = DEMI_FORM_LEAST;
    while (n < DEMI_FORM_MOST && DEMI_PI*DEMI_PI*r/2 > f->chord*n*n) n *= 2;
    return n;
}
/* The corner radius of a polygon of n sides that has the area of a circle of radius r. */
static double demi_draft_radius(double r, int n) {
    const double turn = 2*DEMI_PI/n;
    return r*sqrt(turn/demi_sin(turn));
}
/* Adds a regular polygon of n points about (x, y) at height z. Returns the first. axis: 2 across z,
   0 across x, 1 across y: z, x and y are then along, and across the axis in cyclic order. */
static int32_t demi_draft_ring(demi_draft *f, int axis, int n, double r, double u, double v,
                              double along) {
    const double R = demi_draft_radius(r, n);
    const int32_t first = f->points;
    int i;
    for (i = 0; i < n; i++) {
        double x[3];
        x[axis] = along;
        x[(axis + 1)%3] = u + R*demi_cos(2*DEMI_PI*i/n);
        x[(axis + 2)%3] = v + R*demi_sin(2*DEMI_PI*i/n);
        demi_draft_point(f, x[0], x[1], x[2]);
    }
    return first;
}
/* Joins two rings: of n points from a, and of n, 2 n, n/2 or one (a point on the axis) from b. */
static void demi_draft_band(demi_draft *f, int32_t a, int n, int32_t b, int m) {
    int i;
    if (m < n) { const int32_t c = a; a = b; b = c; i = n; n = m; m = i; }
    for (i = 0; i < m && n == 1; i++) demi_draft_facet(f, a, b + i, b + (i + 1)%m);
    for (i = 0; i < n && n > 1; i++) {
        const int32_t p = a + i, q = a + (i + 1)%n;
        if (m == n) demi_draft_quad(f, p, b + i, b + (i + 1)%n, q);
        else {
            demi_draft_facet(f, p, b + 2*i, b + 2*i + 1);
            demi_draft_facet(f, p, b + 2*i + 1, q);
            demi_draft_facet(f, q, b + 2*i + 1, b + (2*i + 2)%m);
        }
    }
}

/* --- kinds of walls --- */

static void demi_cylinder_tessellate(const demi_wall *wall, demi_draft *f) {
    const int n = demi_draft_sides(f, (double)wall->radius);
    int i;
    demi_draft_ring(f, 2, n, (double)wall->radius, 0, 0, 0);
    for (i = 0; i < n; i++) demi_draft_facet(f, i, (i + 1)%n, 0);
}
/* Adds the next ring of a surface of revolution and joins it to the one before, which begins at
   *at and has *n corners (0: there is none). back: 1: it is the first ring again. */
static void demi_revolved_ring(demi_draft *f, double r, double z, int back, int32_t *at, int *n) {
    const int sides = r > 0 ? demi_draft_sides(f, r) : 1, before = *n;
    const int32_t from = *at;
    *n = sides;
    *at = back ? 0 : r > 0 ? demi_draft_ring(f, 2, sides, r, 0, 0, z)
        : demi_draft_point(f, 0, 0, z);
    if (before) demi_draft_band(f, from, before, *at, sides);
}
/* The rings of the wall, and more between them: where the radius changes by more than a factor of
   four, so that the number of sides doubles or halves at most, and where facets would be more than
   500 times as long as wide (but at most 1000 of these on a piece). */
static void demi_revolved_tessellate(const demi_wall *wall, demi_draft *f) {
    const int last = wall->ring_count - 1;
    /* just below the radius at which circles get twice as many sides */
    const double sides = DEMI_FORM_LEAST;
    const double least = 0.999*sides*sides*2*f->chord/(DEMI_PI*DEMI_PI);
    int32_t at = 0;
    int k, n = 0;
    demi_revolved_ring(f, (double)wall->ring_radius[0], (double)wall->ring_height[0], 0, &at, &n);
    for (k = 1; k <= last; k++) {
        const double a = (double)wall->ring_radius[k - 1], b = (double)wall->ring_radius[k];
        const double g = (double)wall->ring_height[k - 1], h = (double)wall->ring_height[k];
        const double big = DEMI_MAX(a, b), wide = 2*DEMI_PI*big/demi_draft_sides(f, big);
        const int closed = k == last && fabs(b - (double)wall->ring_radius[0]) +
            fabs(h - (double)wall->ring_height[0]) < 1e-9*(double)wall->radius;
        double t = 0, to;
        for (; t < 1 && !f->failed; t = to) {
            const double r = a + t*(b - a), next = b < a ? r/3.99 : DEMI_MAX(3.99*r, least);
            const double size = sqrt((b - a)*(b - a) + (h - g)*(h - g));
            to = DEMI_MIN(1, t + DEMI_MAX(500*wide/size, 1e-3));
            if (b < a ? next > b && r > least : next < b) to = DEMI_MIN(to, (next - a)/(b - a));
            if (to > 1 - 1e-9) to = 1;
            demi_revolved_ring(f, to < 1 ? a + to*(b - a) : b, to < 1 ? g + to*(h - g) : h,
                               closed && to >= 1, &at, &n);
        }
    }
}

/* --- sieves: one cell about a hole --- */

/* A plate with a rectangular or round hole: both faces, with the cell's corners halfway between
   holes, and the wall of the hole. A plate without thickness has one face. */
static void demi_plate_tessellate(const dem_sieve_desc *s, demi_draft *f) {
    const double bar = (double)s->bar, half = (double)s->thickness/2;
    const double b = (double)s->aperture/2;
    const double a = s->kind == DEM_SIEVE_SLOTS ? (double)s->length/2 : b;
    const int round = s->kind == DEM_SIEVE_ROUND, corners = round && s->staggered ? 6 : 4;
    const double root3 = 1.7320508075688772;
    const int n = round ? demi_draft_sides(f, b) : 4, per = n/corners, layers = half > 0 ? 2 : 1;
    int32_t ring[2], rim[2];
    int i, k, layer;
    for (layer = 0; layer < layers; layer++) {
        const double z = layer ? -half : half;
        rim[layer] = f->points;
        for (i = 0; i < corners; i++) {         /* of the cell: halfway between holes */
            const double at = DEMI_PI*(2*i + 1)/corners;
            if (corners == 6)
                demi_draft_point(f, (2*b + bar)/root3*demi_cos(at),
                                (2*b + bar)/root3*demi_sin(at), z);
            else demi_draft_point(f, (i == 0 || i == 3 ? 1 : -1)*(a + bar/2),
                                 (i < 2 ? 1 : -1)*(b + bar/2), z);
        }
        ring[layer] = f->points;
        if (round) demi_draft_ring(f, 2, n, b, 0, 0, z);
        for (i = 0; i < 4 && !round; i++)
            demi_draft_point(f, (i == 0 || i == 3 ? 1 : -1)*a, (i < 2 ? 1 : -1)*b, z);
        for (i = 0; i < corners; i++) {
            const int32_t p = rim[layer] + i, q = rim[layer] + (i + 1)%corners;
            const int from = round ? i*per : i, to = (from + per)%n;
            for (k = from; k < from + per && round; k++)
                demi_draft_facet(f, p, ring[layer] + k, ring[layer] + (k + 1)%n);
            if (round) demi_draft_facet(f, p, ring[layer] + to, q);
            else demi_draft_quad(f, p, ring[layer] + i, ring[layer] + to, q);
        }
    }
    if (layers == 2) demi_draft_band(f, ring[0], n, ring[1], n);
    f->step[0] = demi_v((dem_real)(2*a + bar), 0, 0);
    f->step[1] = corners == 6 ? demi_v((dem_real)(b + bar/2), (dem_real)((2*b + bar)*root3/2), 0)
        : demi_v(0, (dem_real)(2*b + bar), 0);
}
/* One wire, bar or strip between endless slots along x (axis 0) or y (axis 1): a prism of n
   corners, or the four of a strip, of two if it has no thickness. */
static void demi_row_tessellate(const dem_sieve_desc *s, int axis, demi_draft *f) {
    const int wires = demi_sieve_wires(s), flat = !wires && !(s->thickness > 0);
    const double pitch = (double)(s->aperture + s->bar), q = (double)s->bar/2;
    const double z = !wires ? 0 : axis ? (double)s->lift/2 : -(double)s->lift/2;
    const int n = wires ? demi_draft_sides(f, q) : flat ? 2 : 4;
    int32_t end[2];
    int i, k;
    for (k = 0; k < 2; k++) {
        const double along = (k - 0.5)*pitch;
        end[k] = f->points;
        if (wires) demi_draft_ring(f, axis, n, q, axis ? z : pitch/2, axis ? pitch/2 : z, along);
        for (i = 0; i < n && !wires; i++)
            demi_draft_point(f, along, pitch/2 + (i == 0 || i == 3 ? q : -q),
                            (i < 2 ? 1 : -1)*(double)s->thickness/2);
    }
    if (flat) demi_draft_quad(f, end[0], end[0] + 1, end[1] + 1, end[1]);
    else demi_draft_band(f, end[0], n, end[1], n);
    f->step[0] = demi_v((dem_real)pitch, 0, 0);
    f->step[1] = demi_v(0, (dem_real)pitch, 0);
}
static void demi_sieve_tessellate(const demi_wall *wall, demi_draft *f) {
    const dem_sieve_desc *s = &wall->sieve;
    const int endless = s->kind == DEM_SIEVE_SLOTS && !(s->length > 0);
    if (!demi_sieve_wires(s) && !endless) { demi_plate_tessellate(s, f); return; }
    demi_row_tessellate(s, endless ? 0 : 1, f);
    if (s->kind == DEM_SIEVE_WIRES) demi_row_tessellate(s, 0, f);
}
#define DEMI_WALL_FORM(KIND, C, M, T, N, NEAR, TOUCH, BEND, TESS) TESS,
static const demi_tessellate_fn demi_tessellations[] = {0, DEMI_WALLS(DEMI_WALL_FORM)};
/* True if a wall has a tessellation. */
static int demi_wall_tessellates(const demi_wall *wall) {
    return demi_tessellations[wall->kind] && wall->sieve.kind != DEM_SIEVE_REDUCED &&
        !(wall->sieve.kind && wall->sieve.radius > 0);
}
/* Tessellates a wall with chords of at most `chord`, m. The caller frees *f. */
static void demi_draft_begin(demi_draft *f, dem_world *w, const demi_wall *wall, double chord) {
    memset(f, 0, sizeof *f);
    f->w = w;
    f->per = wall->kind == DEMI_WALL_CYLINDER ? 2 : 3;
    f->chord = chord;
    demi_tessellations[wall->kind](wall, f);
}
