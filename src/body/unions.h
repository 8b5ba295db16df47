/* ---------------------------------------------------------------------------------------------
   >>unions
   Unions: several shapes as one rigid body, each with contacts of its own. A piece of a union is
   one of the world's shapes with a position and an orientation. Also polygons of planar worlds,
   which are prisms. A concave polygon is cut into triangles by ear clipping, and these are merged
   into larger convex pieces. Adds shapes to w->shapes.
   --------------------------------------------------------------------------------------------- */

/* Adds a piece to the moments of a union. q: orientation of its principal axes; c: centre, m. */
static void demi_moments_piece(demi_moments *m, const demi_shape *s, dem_quat q, dem_vec3 c) {
    const double I[3] = {(double)s->inertia.x, (double)s->inertia.y, (double)s->inertia.z};
    const double half = (I[0] + I[1] + I[2])/2, x[3] = {(double)c.x, (double)c.y, (double)c.z};
    double R[9];
    int i, k;
    demi_rotation_of(q, R);
    demi_moments_add(m, s->volume, x, 0);
    for (k = 0; k < 3; k++)
        for (i = 0; i < 3; i++) {
            /* second moment along axis k, which is column k of R */
            const double spread = s->volume*(half - I[k]), *r = R + k;
            m->xx[i] += spread*r[3*i]*r[3*i];
            m->xx[3 + i] += spread*r[i == 2 ? 3 : 0]*r[i == 0 ? 3 : 6];
        }
}
/* Sets the bounds of a union, see demi_cluster_bounds. The lever arm of a contact force may be as
   long as the bounding radius. */
static void demi_union_bounds(const dem_world *w, demi_shape *s) {
    const dem_vec3 I = s->inertia;
    const double least = (double)DEMI_MIN(I.x, DEMI_MIN(I.y, I.z));
    int i, k;
    s->thin = DEM_R(1e30);
    s->light = 1;
    for (i = 0; i < s->pieces; i++) {
        const demi_piece *piece = s->piece + i;
        const demi_shape *one = &w->shapes[piece->shape];
        const double *x = one->faces ? one->hull + 4*one->faces : 0;
        dem_real far = one->faces ? 0 : demi_length(piece->at) + one->radius;
        for (k = 0; k < one->corners; k++, x += 3) {
            const dem_vec3 at = dem_quat_rotate(piece->q, demi_d3_real(demi_d3_at(x)));
            far = DEMI_MAX(far, demi_length(demi_add(piece->at, at)));
        }
        s->radius = DEMI_MAX(s->radius, far);
        s->thin = DEMI_MIN(s->thin, one->thin);
        s->blunt = DEMI_MAX(s->blunt, one->blunt);
        s->light = DEMI_MIN(s->light, one->light);
    }
    s->moment_arm = s->radius;
    s->light /= 1 + (double)s->radius*(double)s->radius/least;
}
/* Builds a union of shapes, given by index, position and orientation (null: 0 and no rotation).
   Returns 0 with an error message if memory ran out. */
static int demi_union_make(dem_world *w, const char *call, int count, const int32_t *which,
                           const dem_real *positions, const dem_real *orientations,
                           demi_shape *out) {
    demi_moments m;
    int i;
    memset(&m, 0, sizeof m);
    memset(out, 0, sizeof *out);
    out->piece = (demi_piece *)demi_hold(w, DEMI_SCENE, (size_t)count, sizeof(demi_piece));
    if (!out->piece) { demi_no_memory(w, call); return 0; }
    out->kind = w->shapes[which[0]].kind;
    out->pieces = count;
    for (i = 0; i < count; i++) {
        const demi_shape *one = &w->shapes[which[i]];
        const dem_quat q = orientations ? demi_quat_unit(demi_quat_at(orientations + 4*i))
            : dem_quat_make(1, 0, 0, 0);
        demi_piece *piece = out->piece + i;
        piece->shape = which[i];
        piece->q = dem_quat_multiply(q, one->frame);
        piece->at = dem_quat_rotate(q, one->centre);
        if (positions) piece->at = demi_add(demi_at(positions + 3*i), piece->at);
        demi_moments_piece(&m, one, piece->q, piece->at);
    }
    demi_shape_principal(out, &m);
    for (i = 0; i < count; i++) {
        demi_piece *piece = out->piece + i;
        const dem_quat back = dem_quat_make(out->frame.w, -out->frame.x, -out->frame.y,
                                            -out->frame.z);
        piece->at = dem_quat_unrotate(out->frame, demi_sub(piece->at, out->centre));
        piece->q = demi_quat_unit(dem_quat_multiply(back, piece->q));
    }
    demi_union_bounds(w, out);
    if (w->desc.planar)
        out->equal = (dem_real)sqrt(out->volume/(DEMI_PI*(double)w->desc.thickness));
    return 1;
}
DEM_API dem_shape dem_shape_union_add(dem_world *w, int count, const dem_shape *shapes,
                                      const dem_real *positions, const dem_real *orientations) {
    int32_t which[1000];
    demi_shape shape;
    int i;
    if (demi_null(w, __func__, w, "world") || demi_null(w, __func__, shapes, "shapes") ||
        demi_null(w, __func__, positions, "positions")) return demi_no_shape;
    if (count < 1 || count > 1000) {
        demi_refuse(w, __func__, "count is %d, must be 1 to 1000", count);
        return demi_no_shape;
    }
    for (i = 0; i < count; i++) {
        const dem_quat q = orientations ? demi_quat_at(orientations + 4*i)
            : dem_quat_make(1, 0, 0, 0);
        which[i] = demi_shape_index(w, __func__, shapes[i]);
        if (which[i] < 0) return demi_no_shape;
        if (w->shapes[which[i]].count || w->shapes[which[i]].pieces) {
            demi_refuse(w, __func__, "shape %d is a cluster or a union, must be an ellipsoid, a "
                        "polyhedron or a polygon; pass its pieces instead", which[i] + 1);
            return demi_no_shape;
        }
        if (!demi_place(demi_at(positions + 3*i)) || !demi_quat_finite(q) ||
            !(demi_quat_most(q) > 0) || (w->desc.planar && (positions[3*i + 2] < 0 ||
            positions[3*i + 2] > 0 || q.x < 0 || q.x > 0 || q.y < 0 || q.y > 0))) {
            demi_refuse(w, __func__, "position or orientation of piece %d is not finite, is a zero "
                        "quaternion, or leaves the plane of a planar world; (1, 0, 0, 0) is no "
                        "rotation", i);
            return demi_no_shape;
        }
    }
    if (!demi_union_make(w, __func__, count, which, positions, orientations, &shape))
        return demi_no_shape;
    return demi_shape_adopt(w, __func__, &shape);
}

/* --- polygons, in planar worlds --- */

enum { DEMI_POLYGON = DEM_POLYHEDRON_FACES - 2 };
/* A convex piece of a polygon: its corners, as indices of the polygon's. */
typedef struct demi_cut_out { int count; int32_t corner[DEMI_POLYGON]; } demi_cut_out;
/* Returns twice the area of triangle a, b, c; > 0 if it is counterclockwise. */
static double demi_turn_of(const double *x, int a, int b, int c) {
    return (x[2*b] - x[2*a])*(x[2*c + 1] - x[2*a + 1]) - (x[2*b + 1] - x[2*a + 1])*
        (x[2*c] - x[2*a]);
}
/* True if the sides that begin at corners a and c cross or touch. Sides that share a corner do
   not. */
static int demi_sides_cross(const double *x, int count, int a, int c) {
    const int b = (a + 1)%count, d = (c + 1)%count;
    if (a == c || b == c || d == a) return 0;
    /* both are on one line */
    if (!(fabs(demi_turn_of(x, a, b, c)) > 0) && !(fabs(demi_turn_of(x, a, b, d)) > 0)) {
        const int k = fabs(x[2*b] - x[2*a]) > fabs(x[2*b + 1] - x[2*a + 1]) ? 0 : 1;
        return DEMI_MAX(x[2*a + k], x[2*b + k]) >= DEMI_MIN(x[2*c + k], x[2*d + k]) &&
            DEMI_MAX(x[2*c + k], x[2*d + k]) >= DEMI_MIN(x[2*a + k], x[2*b + k]);
    }
    return demi_turn_of(x, a, b, c)*demi_turn_of(x, a, b, d) <= 0 &&
        demi_turn_of(x, c, d, a)*demi_turn_of(x, c, d, b) <= 0;
}
/* Cuts a counterclockwise polygon into triangles by ear clipping [ERI05]. Returns their number, or
   0 if round-off has left no ear. */
static int demi_polygon_ears(const double *x, int count, demi_cut_out *out) {
    int32_t left[DEMI_POLYGON];
    int i, k, n = count, pieces = 0;
    for (i = 0; i < count; i++) left[i] = i;
    while (n > 2) {
        for (i = 0; i < n; i++) {
            const int a = left[(i + n - 1)%n], b = left[i], c = left[(i + 1)%n];
            if (!(demi_turn_of(x, a, b, c) > 0)) continue;
            for (k = 0; k < n; k++) {
                const int p = left[k];
                if (p == a || p == b || p == c) continue;
                if (demi_turn_of(x, a, b, p) >= 0 && demi_turn_of(x, b, c, p) >= 0 &&
                    demi_turn_of(x, c, a, p) >= 0) break;
            }
            if (k < n) continue;
            out[pieces].count = 3;
            out[pieces].corner[0] = a; out[pieces].corner[1] = b; out[pieces].corner[2] = c;
            pieces++;
            break;
        }
        if (i == n) return 0;
        for (n--; i < n; i++) left[i] = left[i + 1];
    }
    return pieces;
}
/* Merges piece q into p if they share a side and the result is convex. Returns 1 if it does. */
static int demi_pieces_join(const double *x, demi_cut_out *p, const demi_cut_out *q) {
    demi_cut_out all;
    int i, j, k;
    for (i = 0; i < p->count; i++)
        for (j = 0; j < q->count; j++) {
            if (p->corner[i] != q->corner[(j + 1)%q->count] ||
                p->corner[(i + 1)%p->count] != q->corner[j]) continue;
            all.count = 0;                      /* p from behind the side, then q */
            for (k = 1; k <= p->count; k++) all.corner[all.count++] = p->corner[(i + k)%p->count];
            for (k = 2; k < q->count; k++) all.corner[all.count++] = q->corner[(j + k)%q->count];
            for (k = 0; k < all.count; k++)
                if (demi_turn_of(x, all.corner[k], all.corner[(k + 1)%all.count],
                                 all.corner[(k + 2)%all.count]) < 0) break;
            if (k < all.count) continue;
            *p = all;
            return 1;
        }
    return 0;
}
/* Cuts a counterclockwise polygon into convex pieces. Returns their number, or 0 if round-off
   prevents it. */
static int demi_polygon_cut(const double *x, int count, demi_cut_out *out) {
    int i, j, n = demi_polygon_ears(x, count, out);
    for (i = 0; i < n; i++)
        for (j = 0; j < n; j++) {
            if (i == j || !demi_pieces_join(x, &out[i], &out[j])) continue;
            out[j] = out[--n];
            if (i == n) i = j;
            j = -1;                             /* try all others again */
        }
    return n;
}
/* Copies the corners of a polygon to x, counterclockwise, and returns its area, m2; 0 with an error
   message. */
static double demi_polygon_read(dem_world *w, const char *call, int count, const dem_real *points,
                                double *x) {
    double area = 0;
    int i, k;
    if (count < 3 || count > DEMI_POLYGON || !points) {
        demi_refuse(w, call, "count is %d, must be 3 to %d with points (count x 2)", count,
                    DEMI_POLYGON);
        return 0;
    }
    for (i = 0; i < 2*count; i++) {
        x[i] = (double)points[i];
        if (!demi_finite(points[i]) || fabs(x[i]) > DEMI_FARTHEST) {
            demi_refuse(w, call, "point %d is (%g, %g) m, must be finite and between -%g and %g",
                        i/2, (double)points[i/2*2], (double)points[i/2*2 + 1], DEMI_FARTHEST,
                        DEMI_FARTHEST);
            return 0;
        }
    }
    for (i = 1; i + 1 < count; i++) area += demi_turn_of(x, 0, i, i + 1)/2;
    for (i = 0; i < count; i++)
        for (k = 0; k < count; k++)
            if (demi_sides_cross(x, count, i, k)) {
                demi_refuse(w, call, "the sides from point %d and from point %d cross or touch; "
                            "give the corners in order, each once", i, k);
                return 0;
            }
    if (!(area < 0 || area > 0))
        demi_refuse(w, call, "the area is %g m2, must not be 0; give corners that are not on one "
                    "line", area);
    for (i = 0; i < count && area < 0; i++) {
        x[2*i] = (double)points[2*(count - 1 - i)];
        x[2*i + 1] = (double)points[2*(count - 1 - i) + 1];
    }
    return fabs(area);
}
#if !defined(DEM_NO_POLYHEDRA)
DEM_API dem_shape dem_shape_polygon_add(dem_world *w, int count, const dem_real *points) {
    demi_cut_out piece[DEMI_POLYGON];
    double x[2*DEMI_POLYGON], area, high;
    int32_t which[DEMI_POLYGON];
    demi_shape shape;
    dem_shape id = demi_no_shape;
    int i, k, pieces, first;
    if (demi_null(w, __func__, w, "world")) return id;
    if (!w->desc.planar) {
        demi_refuse(w, __func__, "the world is not planar; set planar to 1, or use "
                    "dem_shape_polyhedron_add");
        return id;
    }
    area = demi_polygon_read(w, __func__, count, points, x);
    if (!(area > 0)) return id;
    pieces = demi_polygon_cut(x, count, piece);
    if (!pieces)
        demi_refuse(w, __func__, "the %d corners cannot be cut into convex pieces: some are too "
                    "close to others or to sides; leave those out", count);
    first = w->shape_count;
    high = 2*sqrt(area/DEMI_PI)/3;              /* m, half the thickness of the prisms */
    for (i = 0; i < pieces; i++) {
        dem_real corner[6*DEMI_POLYGON];
        double own = 0;
        for (k = 0; k < 2*piece[i].count; k++) {
            const int c = piece[i].corner[k/2];
            corner[3*k] = (dem_real)x[2*c];
            corner[3*k + 1] = (dem_real)x[2*c + 1];
            corner[3*k + 2] = (dem_real)(k & 1 ? high : -high);
        }
        if (!demi_polyhedron_of(w, __func__, 2*piece[i].count, corner, &shape)) break;
        own = shape.volume/(2*high);
        shape.equal = (dem_real)sqrt(own/DEMI_PI);
        shape.volume = own*(double)w->desc.thickness;
        id = demi_shape_adopt(w, __func__, &shape);
        if (!id.id) break;
        which[i] = id.id - 1;
    }
    if (pieces > 1 && i == pieces)
        id = demi_union_make(w, __func__, pieces, which, 0, 0, &shape)
            ? demi_shape_adopt(w, __func__, &shape) : demi_no_shape;
    if (pieces && i == pieces && id.id) return id;
    while (w->shape_count > first) demi_shape_free(w, &w->shapes[--w->shape_count]);
    return demi_no_shape;
}
#endif
