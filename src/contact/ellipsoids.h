/* ---------------------------------------------------------------------------------------------
   >>ellipsoids
   Contact points of ellipsoids with ellipsoids and spheres, a tile of pairs at a time. >>persistent
   asks for pairs in the order of its list. A tile is filled with the next pairs whose bounding
   spheres overlap, and one iteration of Perram and Wertheim's method [PW85] runs over all of them
   in vectors. With the parameter of the step before as its start, one iteration is nearly always
   enough; the other pairs are solved individually. Owns nothing; the tile belongs to the caller.
   --------------------------------------------------------------------------------------------- */

/* True if a body of this shape is an ellipsoid or a sphere (null). */
DEM_INLINE int demi_ellipsoid_is(const demi_shape *shape) {
    return !shape || (shape->kind == DEMI_ELLIPSOID && !shape->pieces);
}
/* True if the scene has ellipsoids. */
static int demi_ellipsoids_exist(const dem_world *w) {
    int k, any = 0;
    for (k = 0; k < w->shape_count; k++) any |= w->shapes[k].kind == DEMI_ELLIPSOID;
    return any;
}
/* Pairs of a tile, a multiple of DEMI_LANES; how many entries ahead bodies and contacts are
   prefetched. */
enum { DEMI_MEETS = 16, DEMI_MEETS_AHEAD = 6 };
/* What one iteration has found: no contact, a contact, or that more iterations are needed. */
enum { DEMI_MEETS_APART, DEMI_MEETS_FOUND, DEMI_MEETS_OPEN };
/* A tile of pairs, as a structure of arrays. Sides: 0 body a, 1 body b. */
typedef struct demi_ellipsoid_tile {
    dem_real q[2][4][DEMI_MEETS], axes[2][3][DEMI_MEETS];        /* orientations; half axes, m */
    double r[3][DEMI_MEETS];       /* m, from a to b */
    double equal[2][DEMI_MEETS];   /* m, radii of the spheres of equal volume */
    double most[DEMI_MEETS];       /* W0^2 beyond which the two are apart */
    double range[DEMI_MEETS], d[DEMI_MEETS];     /* m: of the law; between the centres */
    double l[DEMI_MEETS];          /* lambda of the step before, 0: unknown; then the start value */
    /* results. found: DEMI_MEETS_..., a double, so that all columns have one width; the others as
       in demi_meet and demi_ellipsoids_keep */
    double found[DEMI_MEETS];
    double to[DEMI_MEETS], f[DEMI_MEETS], w0[DEMI_MEETS], both[DEMI_MEETS];
    double overlap[DEMI_MEETS], slope[DEMI_MEETS], r_eff[DEMI_MEETS], deep[DEMI_MEETS];
    double s[3][DEMI_MEETS], normal[3][DEMI_MEETS], point[3][DEMI_MEETS];
    int32_t entry[DEMI_MEETS], from[DEMI_MEETS]; /* of the pruned list; old contact, -1: none */
    int count, next, end;          /* pairs; the next to be taken; entries up to here were seen */
    const demi_persistent *old;    /* first old contact of body `of` or of a later body, */
    int of, olds;                  /* and the number of those of `of` */
} demi_ellipsoid_tile;

#if defined(__GNUC__) && !defined(__clang__) && !defined(__TINYC__)
#pragma GCC push_options
#pragma GCC optimize("no-trapping-math")
#endif
DEM_INLINE void demi_ellipsoids_put(double (*rows)[DEMI_MEETS], int q, demi_d3 a) {
    rows[0][q] = a.x; rows[1][q] = a.y; rows[2][q] = a.z;
}
DEM_INLINE demi_d3 demi_ellipsoids_at(double (*rows)[DEMI_MEETS], int q) {
    return demi_d(rows[0][q], rows[1][q], rows[2][q]);
}
/* The matrix of a side of row q. */
DEM_INLINE demi_sym demi_ellipsoid_row(const demi_ellipsoid_tile *t, int side, int q) {
    return demi_ellipsoid_matrix(
        dem_quat_make(t->q[side][0][q], t->q[side][1][q], t->q[side][2][q], t->q[side][3][q]),
        demi_v(t->axes[side][0][q], t->axes[side][1][q], t->axes[side][2][q]));
}
/* Stores the contact point of row q. At that point both scaled distances are W0, so the support
   heights are h_A = W0/((1 - l) |s|) and h_B = W0/(l |s|); both: their sum. The overlap is the
   conservative one. */
DEM_INLINE void demi_ellipsoids_keep(demi_ellipsoid_tile *DEMI_RESTRICT t, int q, demi_meet m) {
    const double w0 = sqrt(m.f), per = 1/demi_d3_length(m.s), least = m.l < 0.5 ? m.l : 1 - m.l;
    const double radii = t->equal[0][q] + t->equal[1][q];
    t->to[q] = m.l;
    t->f[q] = m.f;
    t->w0[q] = w0;
    t->both[q] = w0*per/(m.l*(1 - m.l));
    t->overlap[q] = (1 - w0)*radii;
    t->slope[q] = radii/t->both[q];
    t->r_eff[q] = t->equal[0][q]*t->equal[1][q]/radii;
    t->deep[q] = (1 - w0)/least;
    demi_ellipsoids_put(t->s, q, m.s);
    demi_ellipsoids_put(t->normal, q, demi_d3_scale(m.s, per));
    demi_ellipsoids_put(t->point, q, demi_d3_scale(m.a, 1 - m.l));
}
/* One iteration for row q. It ends as the first of demi_meet_solve does. Without a start value, the
   plane normal to the line of centres is tried first: W0 >= d/(h_A + h_B), with the support heights
   along that line, so if the plane separates the two, they are apart. */
DEM_INLINE void demi_ellipsoids_solve_one(demi_ellipsoid_tile *DEMI_RESTRICT t, int q) {
    const demi_sym A = demi_ellipsoid_row(t, 0, q), B = demi_ellipsoid_row(t, 1, q);
    const demi_d3 r = demi_ellipsoids_at(t->r, q);
    const double ha = demi_sym_height(A, r), hb = demi_sym_height(B, r);
    const int fresh = !(t->l[q] > 0);
    const int apart = fresh & (demi_d3_square(r) - (ha + hb) > t->range[q]*t->d[q]);
    demi_meet m, n;
    int out, still;
    m.l = fresh ? demi_meet_start(ha, hb) : t->l[q];
    t->l[q] = m.l;
    demi_meet_at(A, B, r, &m);
    n = m;
    demi_meet_finish(A, &n);
    out = m.f > t->most[q];
    still = !out & (m.fa + m.fb > 0) & (fabs(m.u) < DEMI_MEET_NEAR);
    if (still) m = n;
    demi_ellipsoids_keep(t, q, m);
    t->found[q] = apart ? (double)DEMI_MEETS_APART
        : still | out ? (double)DEMI_MEETS_FOUND : (double)DEMI_MEETS_OPEN;
}
DEMI_CLONES static void demi_ellipsoids_solve(demi_ellipsoid_tile *DEMI_RESTRICT t, int full) {
    DEMI_ROWS(full) demi_ellipsoids_solve_one(t, q); DEMI_ROWS_END
}
#if defined(__GNUC__) && !defined(__clang__) && !defined(__TINYC__)
#pragma GCC pop_options
#endif

/* Puts one side into row k of a tile. Returns its least half axis, m. */
DEM_INLINE dem_real demi_ellipsoid_put(demi_ellipsoid_tile *t, int k, int side, dem_quat q,
                                       dem_vec3 axes) {
    t->q[side][0][k] = q.w; t->q[side][1][k] = q.x;
    t->q[side][2][k] = q.y; t->q[side][3][k] = q.z;
    t->axes[side][0][k] = axes.x; t->axes[side][1][k] = axes.y; t->axes[side][2][k] = axes.z;
    return DEMI_MIN(axes.x, DEMI_MIN(axes.y, axes.z));
}
/* Puts all but the two bodies into row k. gap: m, from a to b; lambda: of the step before, 0:
   unknown; range: m, of the law; thin: sum of the least half axes, m. */
DEM_INLINE void demi_ellipsoids_row(demi_ellipsoid_tile *t, int k, dem_vec3 gap, double lambda,
                                    double range, dem_real thin) {
    const double most = range > 0 ? 1 + range/(double)thin : 1;
    demi_ellipsoids_put(t->r, k, demi_d3_of(gap));
    if (!(demi_dot(gap, gap) > 0)) t->r[2][k] = 1e-9*(double)thin;
    t->l[k] = lambda;
    t->most[k] = most*most;
    t->range[k] = range;
    t->d[k] = range > 0 ? demi_d3_length(demi_d3_of(gap)) : 0;
}
/* Puts a body into row k: an ellipsoid, or a sphere, which has three equal axes. */
DEM_INLINE dem_real demi_ellipsoid_body_put(const dem_world *w, demi_ellipsoid_tile *t, int k,
                                            int side, int body, const demi_shape *shape) {
    const dem_real radius = demi_radius(w, body), scale = shape ? radius/shape->radius : 0;
    t->equal[side][k] = (double)(shape ? shape->equal*scale : radius);
    if (!shape)
        return demi_ellipsoid_put(t, k, side, dem_quat_make(1, 0, 0, 0),
                                  demi_v(radius, radius, radius));
    return demi_ellipsoid_put(t, k, side, demi_quat_at(w->bodies.orient + 4*body),
                              demi_scale(shape->axes, scale));
}
/* Fills a tile with pairs of ellipsoids among entries p .. end - 1 of the pruned list of work group
   d, and does one iteration for all of them. */
static DEMI_APART void demi_ellipsoids_find(dem_world *w, int d, int p, int end,
                                             demi_ellipsoid_tile *t) {
    const int base = d*w->near.stride;
    const demi_persistent *now = demi_persistent_of(w, d), *o;
    const demi_persistent *last = now + w->domains[d].persistent;
    demi_persistent key;
    int k;
    memset(&key, 0, sizeof key);
    key.wall = key.element = -1;
    t->count = t->next = 0;
    for (; p < end && t->count < DEMI_MEETS; p++) {
        const int a = w->near.a[base + p], b = w->near.b[base + p];
        const size_t at = (size_t)(base + p);
        const dem_vec3 r = demi_near_level(w, at, demi_near_bodies_way(w, at));
        const dem_real radii = demi_radius(w, a) + demi_radius(w, b);
        const dem_real far = radii + (dem_real)w->margin.reach;
        const demi_shape *one, *other;
        dem_real thin;
        if (p + DEMI_MEETS_AHEAD < end) {
            const int next = w->near.b[base + p + DEMI_MEETS_AHEAD];
            DEMI_FETCH(w->bodies.pos + 4*next);
            DEMI_FETCH(w->bodies.orient + 4*next);
        }
        if (!(demi_dot(r, r) < far*far)) continue;
        one = demi_shape_of(w, a);
        other = demi_shape_of(w, b);
        if ((!one && !other) || !demi_ellipsoid_is(one) || !demi_ellipsoid_is(other)) continue;
        k = t->count++;
        if (t->of != a) {
            while (t->old < last && t->old->a < a) t->old++;
            for (t->olds = 0; t->old + t->olds < last && t->old[t->olds].a == a;) t->olds++;
            t->of = a;
        }
        key.b = b;
        t->entry[k] = p;
        t->from[k] = demi_persistent_same(w, d, t->old, t->olds, &key);
        o = t->from[k] < 0 ? 0 : now + t->from[k];
        if (t->old + t->olds + DEMI_MEETS_AHEAD < last)
            DEMI_FETCH(t->old + t->olds + DEMI_MEETS_AHEAD);
        thin = demi_ellipsoid_body_put(w, t, k, 0, a, one);
        thin += demi_ellipsoid_body_put(w, t, k, 1, b, other);
        demi_ellipsoids_row(t, k, r, o ? o->lambda : 0, (double)demi_range(w, radii), thin);
    }
    t->end = p;
    for (k = t->count; k%DEMI_LANES; k++) {     /* copies of two spheres pad the last group */
        demi_ellipsoid_put(t, k, 0, dem_quat_make(1, 0, 0, 0), demi_v(1, 1, 1));
        demi_ellipsoid_put(t, k, 1, dem_quat_make(1, 0, 0, 0), demi_v(1, 1, 1));
        t->equal[0][k] = t->equal[1][k] = 1;
        demi_ellipsoids_row(t, k, demi_v(1, 0, 0), 0, 0, 1);
    }
    if (t->count) demi_ellipsoids_solve(t, k);
}
/* Returns 1 if the pair of row k touches or is within the range of the law; its contact point is
   then complete. If the two are apart, their gap is taken as d (1 - 1/W0), the distance of the two
   surface points that coincide when both are scaled by W0. It is never less than the true distance,
   which the candidate lists use. */
static int demi_ellipsoids_meet(demi_ellipsoid_tile *t, int k) {
    demi_meet m;
    if (!(t->found[k] > (double)DEMI_MEETS_APART)) return 0;
    if (t->found[k] > (double)DEMI_MEETS_FOUND) {
        m.l = t->l[k];
        demi_meet_solve(demi_ellipsoid_row(t, 0, k), demi_ellipsoid_row(t, 1, k),
                        demi_ellipsoids_at(t->r, k), t->most[k], DEMI_MEET_NEAR, &m);
        demi_ellipsoids_keep(t, k, m);
    }
    return t->f[k] < 1 || (t->range[k] > 0 && t->d[k]*(1 - 1/t->w0[k]) < t->range[k]);
}
/* Returns the overlap of [RUB15] 3.2 for row k, m. Evaluates the function once more: with K^-1 QB s
   from before the last step of l, the error would be of the order of this step. */
static double demi_ellipsoids_chord(demi_ellipsoid_tile *t, int k) {
    const demi_sym A = demi_ellipsoid_row(t, 0, k);
    demi_meet m;
    m.l = t->to[k];
    demi_meet_at(A, demi_ellipsoid_row(t, 1, k), demi_ellipsoids_at(t->r, k), &m);
    return demi_meet_chord(&m, A);
}
