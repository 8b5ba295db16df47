/* ---------------------------------------------------------------------------------------------
   >>hulls
   Convex polyhedra as shapes: the convex hull of points, its faces, mass properties and bounds.
   The hull grows point by point, the farthest first, as a set of triangles (quickhull). Adjacent
   triangles in one plane are then merged to a face. Also copies shapes between worlds. Contacts of
   polyhedra are in >>polyhedra.
   --------------------------------------------------------------------------------------------- */

/* (4 pi/3)^(1/3): edge of a cube over the radius of the sphere of equal volume. */
#define DEMI_POLYHEDRON_SCALE 1.6119919540164696
/* A triangle of an unfinished hull. */
typedef struct demi_hull_face {
    /* points, counterclockwise from outside; triangles across the sides from corner k to k + 1 */
    int32_t corner[3], beside[3];
    /* 0: unused, 1: of the hull, 2: visible from the point being added; its face, or -1 */
    int32_t state, face;
    demi_d3 n;                     /* unit, outward */
    double at;                     /* m: n.x of its plane */
} demi_hull_face;
/* A polyhedron has at most 2 faces - 4 corners, and 2 corners - 4 triangles. There is more room,
   because new triangles are added before those that they replace are removed. */
enum { DEMI_HULL_CORNERS = 2*DEM_POLYHEDRON_FACES - 4, DEMI_HULL_ROOM = 4*DEMI_HULL_CORNERS };
/* An unfinished hull. */
typedef struct demi_hull {
    int count, used, corners;      /* points; entries of faces; corners so far */
    const demi_d3 *x;              /* m, count: the points */
    double near;                   /* m: points nearer than this to a plane are in it */
    int32_t *first;                /* count: new triangle, by the first corner of its outer side */
    demi_hull_face *faces;         /* DEMI_HULL_ROOM */
} demi_hull;

/* Returns the distance of a point from the plane of a triangle, m, > 0 outside. */
static double demi_hull_above(const demi_hull *h, const demi_hull_face *f, int point) {
    return demi_d3_dot(f->n, h->x[point]) - f->at;
}
/* Adds a triangle and returns it, or null if there is no room. */
static demi_hull_face *demi_hull_new(demi_hull *h, int a, int b, int c) {
    demi_hull_face *f;
    int i;
    for (i = 0; i < h->used && h->faces[i].state; i++) continue;
    if (i == DEMI_HULL_ROOM) return 0;
    h->used = DEMI_MAX(h->used, i + 1);
    f = h->faces + i;
    f->corner[0] = a; f->corner[1] = b; f->corner[2] = c;
    f->n = demi_d3_unit(demi_d3_normal(h->x[a], h->x[b], h->x[c]));
    f->at = demi_d3_dot(f->n, h->x[a]);
    f->state = 1;
    f->face = -1;
    return f;
}
/* Finds the point farthest from point a (if a = b = c), from the line through a and b (if c = a),
   or from the plane through a, b and c. Returns its distance, m. */
static double demi_hull_far(const demi_hull *h, int a, int b, int c, int *far) {
    demi_d3 u = demi_d3_unit(demi_d3_sub(h->x[b], h->x[a]));
    double most = 0;
    int i;
    if (c != a) u = demi_d3_unit(demi_d3_cross(demi_d3_sub(h->x[c], h->x[a]), u));
    for (i = 0; i < h->count; i++) {
        const demi_d3 v = demi_d3_sub(h->x[i], h->x[a]);
        const double d = c != a ? fabs(demi_d3_dot(u, v))
            : demi_d3_length(a == b ? v : demi_d3_cross(u, v));
        if (d > most) { most = d; *far = i; }
    }
    return most;
}
/* Sets up the initial tetrahedron. Returns 0 if all points are in one plane. */
static int demi_hull_begin(demi_hull *h) {
    static const int32_t beside[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    int p[4] = {0, 0, 0, 0}, i, k;
    for (i = 0; i < DEMI_HULL_ROOM; i++) h->faces[i].state = 0;
    h->used = 0;
    if (!(demi_hull_far(h, 0, 0, 0, &p[0]) > h->near) ||
        !(demi_hull_far(h, p[0], p[0], p[0], &p[1]) > h->near) ||
        !(demi_hull_far(h, p[0], p[1], p[0], &p[2]) > h->near) ||
        !(demi_hull_far(h, p[0], p[1], p[2], &p[3]) > h->near)) return 0;
    demi_hull_new(h, p[0], p[1], p[2]);
    if (demi_hull_above(h, h->faces, p[3]) > 0) {       /* must be inside the plane of the first */
        h->faces[0].state = 0;
        i = p[1]; p[1] = p[2]; p[2] = i;
        demi_hull_new(h, p[0], p[1], p[2]);
    }
    demi_hull_new(h, p[1], p[0], p[3]);
    demi_hull_new(h, p[2], p[1], p[3]);
    demi_hull_new(h, p[0], p[2], p[3]);
    for (i = 0; i < 4; i++) for (k = 0; k < 3; k++) h->faces[i].beside[k] = beside[i][k];
    h->corners = 4;
    return 1;
}
/* Returns the point farthest outside, and in *face the triangle from whose plane it is farthest; -1
   if no point is outside. */
static int demi_hull_next(const demi_hull *h, int *face) {
    double most = h->near;
    int i, k, next = -1;
    for (k = 0; k < h->used; k++)
        for (i = 0; h->faces[k].state && i < h->count; i++) {
            const double d = demi_hull_above(h, h->faces + k, i);
            if (d > most) { most = d; next = i; *face = k; }
        }
    return next;
}
/* Adds a point to the hull: replaces the connected triangles that are visible from it by triangles
   from their rim to the point. Returns 0 if there is no room, or if round-off has left a rim that
   is not one loop. */
static int demi_hull_take(demi_hull *h, int point, int from) {
    int32_t seen[DEMI_HULL_ROOM];
    int i, k, count = 0, rim = 0;
    h->faces[from].state = 2;
    seen[count++] = from;
    for (i = 0; i < count; i++)
        for (k = 0; k < 3; k++) {
            const int32_t next = h->faces[seen[i]].beside[k];
            if (h->faces[next].state != 1 ||
                !(demi_hull_above(h, h->faces + next, point) > h->near)) continue;
            h->faces[next].state = 2;
            seen[count++] = next;
        }
    for (i = 0; i < h->count; i++) h->first[i] = -1;
    for (i = 0; i < count; i++)
        for (k = 0; k < 3; k++) {
            const demi_hull_face *f = h->faces + seen[i];
            const int32_t out = f->beside[k], a = f->corner[k], b = f->corner[(k + 1)%3];
            demi_hull_face *fresh;
            int e;
            if (h->faces[out].state != 1) continue;
            fresh = demi_hull_new(h, a, b, point);
            if (!fresh || h->first[a] >= 0) return 0;
            h->first[a] = (int32_t)(fresh - h->faces);
            fresh->beside[0] = out;
            for (e = 0; e < 3 && h->faces[out].corner[e] != b; e++) continue;
            if (e == 3) return 0;
            h->faces[out].beside[e] = h->first[a];
            rim++;
        }
    for (i = 0; i < h->count; i++) {
        const int32_t here = h->first[i];
        int32_t next;
        if (here < 0) continue;
        next = h->first[h->faces[here].corner[1]];
        if (next < 0) return 0;
        h->faces[here].beside[1] = next;
        h->faces[next].beside[2] = here;
    }
    for (i = 0; i < count; i++) h->faces[seen[i]].state = 0;
    h->corners++;
    return rim > 2;
}
/* True if triangle k is in the plane of f. */
static int demi_hull_flush(const demi_hull *h, const demi_hull_face *f, int k) {
    int e;
    for (e = 0; e < 3; e++)
        if (fabs(demi_hull_above(h, f, h->faces[k].corner[e])) > h->near) return 0;
    return demi_d3_dot(f->n, h->faces[k].n) > 0.5;
}
/* Merges adjacent triangles in one plane to faces, beginning with the largest triangle, and numbers
   them. Returns the number of faces. */
static int demi_hull_faces(demi_hull *h) {
    int32_t row[DEMI_HULL_ROOM];
    int faces = 0, i, k, count;
    for (;; faces++) {
        double most = -1;
        int from = -1;
        for (i = 0; i < h->used; i++) {
            const demi_hull_face *f = h->faces + i;
            double area;
            if (f->state != 1 || f->face >= 0) continue;
            area = demi_d3_square(demi_d3_normal(h->x[f->corner[0]], h->x[f->corner[1]],
                                                 h->x[f->corner[2]]));
            if (area > most) { most = area; from = i; }
        }
        if (from < 0) return faces;
        h->faces[from].face = faces;
        row[0] = from;
        for (i = 0, count = 1; i < count; i++)
            for (k = 0; k < 3; k++) {
                const int32_t next = h->faces[row[i]].beside[k];
                if (h->faces[next].face >= 0 || !demi_hull_flush(h, h->faces + from, next))
                    continue;
                h->faces[next].face = faces;
                row[count++] = next;
            }
    }
}
/* Gives the corners of a face in their order, as point numbers. Returns their number, or 0 if the
   rim is not one loop. */
static int demi_hull_loop(const demi_hull *h, int face, int32_t *loop) {
    int i, k, sides = 0, begin = -1, count = 0;
    for (i = 0; i < h->used; i++)
        for (k = 0; k < 3 && h->faces[i].state == 1 && h->faces[i].face == face; k++)
            if (h->faces[h->faces[i].beside[k]].face != face) {
                h->first[h->faces[i].corner[k]] = h->faces[i].corner[(k + 1)%3];
                begin = h->faces[i].corner[k];
                sides++;
            }
    for (k = begin; count < sides; k = h->first[k]) loop[count++] = k;
    for (i = 1; i < count; i++) if (loop[i] == begin) return 0;
    return k == begin && sides > 2 ? sides : 0;
}
/* Computes the unit normal of a loop of corners (Newell), and its distance from the origin, m.
   Returns twice its area, m2. */
static double demi_loop_plane(const demi_d3 *x, const int32_t *loop, int n, demi_d3 *normal,
                              double *high) {
    demi_d3 twice = demi_d(0, 0, 0);
    int i;
    for (i = 1; i + 1 < n; i++)
        twice = demi_d3_add(twice, demi_d3_normal(x[loop[0]], x[loop[i]], x[loop[i + 1]]));
    *normal = demi_d3_unit(twice);
    for (i = 0, *high = 0; i < n; i++) *high += demi_d3_dot(*normal, x[loop[i]])/n;
    return demi_d3_length(twice);
}
/* True if no point is outside and every corner of a face is in its plane, within 20 h->near. */
static int demi_hull_holds(const demi_hull *h, const int32_t *rim, int faces) {
    const int32_t *loops = rim + faces + 1;
    int f, i;
    for (f = 0; f < faces; f++) {
        demi_d3 n;
        double at;
        if (!(demi_loop_plane(h->x, loops + rim[f], rim[f + 1] - rim[f], &n, &at) > 0)) return 0;
        for (i = 0; i < h->count; i++)
            if (demi_d3_dot(n, h->x[i]) - at > 20*h->near) return 0;
        for (i = rim[f]; i < rim[f + 1]; i++)
            if (demi_d3_dot(n, h->x[loops[i]]) - at < -20*h->near) return 0;
    }
    return 1;
}
/* Computes the convex hull. rim receives its faces: faces + 1 starts, then corners as point
   numbers. Returns the number of faces; 0 if round-off has made it inconsistent; -1 if the points
   are in one plane; more than DEM_POLYHEDRON_FACES if it has too many, without filling rim. */
static int demi_hull_of(demi_hull *h, int32_t *rim) {
    int faces, face = 0, next, f, n = 0;
    if (!demi_hull_begin(h)) return -1;
    while ((next = demi_hull_next(h, &face)) >= 0) {
        if (h->corners == h->count) return 0;
        if (h->corners == DEMI_HULL_CORNERS) return DEM_POLYHEDRON_FACES + 1;
        if (!demi_hull_take(h, next, face)) return 0;
    }
    faces = demi_hull_faces(h);
    if (faces > DEM_POLYHEDRON_FACES) return faces;
    for (f = 0; f < faces; f++) {
        const int sides = demi_hull_loop(h, f, rim + faces + 1 + n);
        if (!sides) return 0;
        rim[f] = n;
        n += sides;
    }
    rim[faces] = n;
    return demi_hull_holds(h, rim, faces) ? faces : 0;
}
/* Rows and columns of a symmetric tensor: xx yy zz xy xz yz. */
static const int demi_sym_row[6] = {0, 1, 2, 0, 0, 1}, demi_sym_column[6] = {0, 1, 2, 1, 2, 2};
/* Adds the exact moments of the tetrahedron of the origin and a triangle. */
static void demi_moments_tetrahedron(demi_moments *m, demi_d3 x, demi_d3 y, demi_d3 z) {
    const double v = demi_d3_dot(x, demi_d3_cross(y, z))/6;
    double a[3], b[3], c[3], s[3];
    int k;
    demi_d3_put(a, x);
    demi_d3_put(b, y);
    demi_d3_put(c, z);
    demi_d3_put(s, demi_d3_add(demi_d3_add(x, y), z));
    m->one += v;
    for (k = 0; k < 3; k++) m->x[k] += v*s[k]/4;
    for (k = 0; k < 6; k++) {
        const int p = demi_sym_row[k], r = demi_sym_column[k];
        m->xx[k] += v*(s[p]*s[r] + a[p]*a[r] + b[p]*b[r] + c[p]*c[r])/20;
    }
}
/* Computes the volume integrals of a polyhedron. */
static void demi_polyhedron_moments(const demi_d3 *x, const int32_t *rim, int faces,
                                    demi_moments *m) {
    const int32_t *loops = rim + faces + 1;
    int f, i;
    memset(m, 0, sizeof *m);
    for (f = 0; f < faces; f++)
        for (i = rim[f] + 1; i + 1 < rim[f + 1]; i++)
            demi_moments_tetrahedron(m, x[loops[rim[f]]], x[loops[i]], x[loops[i + 1]]);
}
/* Writes the corners in use, renumbered, to a shape, in its principal frame; then its planes. */
static void demi_polyhedron_lay(demi_shape *s, const demi_d3 *x, int32_t *number) {
    int32_t *loops = s->rim + s->faces + 1;
    demi_d3 corner[DEMI_HULL_CORNERS], n;
    int i, f;
    for (i = 0; i < s->rim[s->faces]; i++) {
        if (number[loops[i]] < 0) {
            const dem_vec3 at = demi_sub(demi_d3_real(x[loops[i]]), s->centre);
            number[loops[i]] = s->corners;
            corner[s->corners++] = demi_d3_of(dem_quat_unrotate(s->frame, at));
        }
        loops[i] = number[loops[i]];
    }
    for (i = 0; i < s->corners; i++) demi_d3_put(s->hull + 4*s->faces + 3*i, corner[i]);
    for (f = 0; f < s->faces; f++) {
        double *plane = s->hull + 4*f;
        demi_loop_plane(corner, loops + s->rim[f], s->rim[f + 1] - s->rim[f], &n, plane + 3);
        demi_d3_put(plane, demi_d3_over(n, plane[3]));
    }
}
/* Sets the bounds of a polyhedron, see demi_cluster_bounds. On a plane the overlap of a face grows
   by `slope` per m of approach, slope^2 = area/(2 (4 pi/3)^(1/3) r h) (>>polyhedra). This, and
   rotation about the lever arm of the face reduce the effective mass. */
static void demi_polyhedron_bounds(demi_shape *s) {
    const int32_t *loops = s->rim + s->faces + 1;
    const dem_vec3 I = s->inertia;
    const double least = (double)DEMI_MIN(I.x, DEMI_MIN(I.y, I.z));
    const double r = demi_cube_root(s->volume*3/(4*DEMI_PI));
    demi_d3 corner[DEMI_HULL_CORNERS], n;
    int f, i;
    s->radius = s->moment_arm = 0;
    s->thin = (dem_real)r;
    s->blunt = (dem_real)r;
    s->light = 1;
    for (i = 0; i < s->corners; i++) {
        corner[i] = demi_d3_at(s->hull + 4*s->faces + 3*i);
        s->radius = DEMI_MAX(s->radius, (dem_real)demi_d3_length(corner[i]));
    }
    for (f = 0; f < s->faces; f++) {
        const double h = s->hull[4*f + 3];
        double high, arm = 0, slope;
        const double area = demi_loop_plane(corner, loops + s->rim[f], s->rim[f + 1] - s->rim[f],
                                            &n, &high)/2;
        for (i = s->rim[f]; i < s->rim[f + 1]; i++)
            arm = DEMI_MAX(arm, demi_d3_square(corner[loops[i]]) - h*h);
        slope = area/(2*DEMI_POLYHEDRON_SCALE*r*h);
        s->thin = DEMI_MIN(s->thin, (dem_real)h);
        s->moment_arm = DEMI_MAX(s->moment_arm, (dem_real)sqrt(arm));
        s->light = DEMI_MIN(s->light, 1/(DEMI_MAX(slope, 1)*(1 + arm/least)));
    }
}
/* Makes the hull of points a shape. The box of the points must be centred at the origin; size: its
   diagonal, m. Increases the tolerance until the hull is consistent. Returns 0 with an error
   message if it never is, or is flat or has too many faces. */
static int demi_polyhedron_make(dem_world *w, const char *call, demi_hull *h, double size,
                                demi_shape *shape) {
    int32_t rim[7*DEM_POLYHEDRON_FACES];
    demi_moments m;
    int faces = 0, i;
    for (h->near = (DEMI_SINGLE ? 1e-6 : 1e-10)*size; h->near < 2e-5*size; h->near *= 10) {
        const int now = demi_hull_of(h, rim);
        if (now || !faces) faces = now;
        if (faces && faces <= DEM_POLYHEDRON_FACES) break;
    }
    if (faces < 0)
        demi_refuse(w, call, "the %d points lie in one plane within %.1g m; a polyhedron needs "
                    "four points that do not", h->count, h->near);
    else if (faces > DEM_POLYHEDRON_FACES)
        demi_refuse(w, call, "the hull of the %d points has more than %d faces; give fewer points, "
                    "or use an ellipsoid or a cluster of spheres for a round body", h->count,
                    DEM_POLYHEDRON_FACES);
    else if (!faces)
        demi_refuse(w, call, "the hull of the %d points does not close, likely because many points "
                    "lie nearly, but not exactly, in one plane or on one line; give only the "
                    "corners", h->count);
    if (faces < 1 || faces > DEM_POLYHEDRON_FACES) return 0;
    demi_polyhedron_moments(h->x, rim, faces, &m);
    demi_shape_principal(shape, &m);
    if (!(shape->inertia.x > 0 && shape->inertia.y > 0 && shape->inertia.z > 0)) {
        demi_refuse(w, call, "the hull of the %d points is so flat that its volume is %.2g m3; "
                    "give it some thickness", h->count, shape->volume);
        return 0;
    }
    shape->faces = faces;
    shape->hull = (double *)demi_hold(w, DEMI_SCENE, (size_t)(4*faces + 3*h->corners),
                                      sizeof(double));
    shape->rim = (int32_t *)demi_hold(w, DEMI_SCENE, (size_t)(faces + 1 + rim[faces]),
                                      sizeof(int32_t));
    if (!shape->hull || !shape->rim) { demi_no_memory(w, call); return 0; }
    memcpy(shape->rim, rim, (size_t)(faces + 1 + rim[faces])*sizeof(int32_t));
    for (i = 0; i < h->count; i++) h->first[i] = -1;
    demi_polyhedron_lay(shape, h->x, h->first);
    return 1;
}
/* Makes the hull of points a complete shape, without adding it to the world. Returns 0 with an
   error message. */
static int demi_polyhedron_of(dem_world *w, const char *call, int count, const dem_real *points,
                              demi_shape *shape) {
    dem_vec3 lo, hi, middle;
    demi_hull h;
    demi_d3 *x;
    int i, made = 0;
    if (count < 4 || count > 10000 || !points) {
        demi_refuse(w, call, "count is %d, must be 4 to 10000 with points (count x 3)", count);
        return 0;
    }
    lo = hi = demi_at(points);
    for (i = 0; i < count; i++) {
        const dem_vec3 p = demi_at(points + 3*i);
        if (!demi_finite3(p)) {
            demi_refuse(w, call, "point %d is (%g, %g, %g) m, must be finite", i, (double)p.x,
                        (double)p.y, (double)p.z);
            return 0;
        }
        lo = demi_v(DEMI_MIN(lo.x, p.x), DEMI_MIN(lo.y, p.y), DEMI_MIN(lo.z, p.z));
        hi = demi_v(DEMI_MAX(hi.x, p.x), DEMI_MAX(hi.y, p.y), DEMI_MAX(hi.z, p.z));
    }
    memset(&h, 0, sizeof h);
    memset(shape, 0, sizeof *shape);
    shape->kind = DEMI_POLYHEDRON;
    h.count = count;
    middle = demi_scale(demi_add(lo, hi), DEM_R(0.5));
    x = (demi_d3 *)demi_alloc(w, (size_t)count, sizeof *x);
    h.x = x;
    h.first = (int32_t *)demi_alloc(w, (size_t)count, sizeof(int32_t));
    h.faces = (demi_hull_face *)demi_alloc(w, DEMI_HULL_ROOM, sizeof(demi_hull_face));
    if (!x || !h.first || !h.faces) demi_no_memory(w, call);
    else {
        for (i = 0; i < count; i++)
            x[i] = demi_d3_sub(demi_d3_of(demi_at(points + 3*i)), demi_d3_of(middle));
        made = demi_polyhedron_make(w, call, &h, (double)demi_length(demi_sub(hi, lo)), shape);
    }
    demi_free(w, x);
    demi_free(w, h.first);
    demi_free(w, h.faces);
    if (!made) { demi_shape_free(w, shape); return 0; }
    demi_polyhedron_bounds(shape);
    shape->centre = demi_add(shape->centre, middle);
    return 1;
}
#if !defined(DEM_NO_POLYHEDRA)
DEM_API dem_shape dem_shape_polyhedron_add(dem_world *w, int count, const dem_real *points) {
    demi_shape shape;
    if (demi_null(w, __func__, w, "world") || demi_shape_planar(w, __func__)) return demi_no_shape;
    if (!demi_polyhedron_of(w, __func__, count, points, &shape)) return demi_no_shape;
    return demi_shape_adopt(w, __func__, &shape);
}
#endif
/* Returns the depth of a point, in the frame the shape was given in, below its faces, m. */
static dem_real demi_polyhedron_depth(const demi_shape *s, dem_vec3 at) {
    const demi_d3 x = demi_d3_of(dem_quat_unrotate(s->frame, demi_sub(at, s->centre)));
    const double *a = s->hull;
    double least = 1e300;
    int f;
    for (f = 0; f < s->faces; f++, a += 4)
        least = DEMI_MIN(least, (1 - demi_d3_dot(demi_d3_at(a), x))*a[3]);
    return (dem_real)least;
}
/* Returns 0 with an error message if there are no vertices or elements, if a coordinate is not
   finite or too large, or if an element names a vertex that does not exist. */
static int demi_mesh_sound(dem_world *w, const char *call, int vertices, const dem_real *xyz,
                           int per_vertex, int elements, const int32_t *corners,
                           int per_element) {
    int i;
    if (vertices < 1 || elements < 1 || vertices > INT_MAX/8 || elements > INT_MAX/8 || !xyz ||
        (per_element && !corners)) {
        demi_refuse(w, call, "there are %d vertices and %d elements; there must be at least one "
                    "and at most %d of each, with pointers to them; was the file read?", vertices,
                    elements, INT_MAX/8);
        return 0;
    }
    for (i = 0; i < vertices*per_vertex; i++)
        if (!demi_finite(xyz[i]) || fabs((double)xyz[i]) > DEMI_FARTHEST) {
            demi_refuse(w, call, "a coordinate of vertex %d is %g m, must be finite and between "
                        "-%g and %g; check that the file was read completely and is in metres",
                        i/per_vertex, (double)xyz[i], DEMI_FARTHEST, DEMI_FARTHEST);
            return 0;
        }
    for (i = 0; i < elements*per_element; i++)
        if (corners[i] < 0 || corners[i] >= vertices) {
            demi_refuse(w, call, "element %d names vertex %d, must be 0 to %d; are vertices "
                        "numbered from 1 in the file?", i/per_element, (int)corners[i],
                        vertices - 1);
            return 0;
        }
    return 1;
}
/* Makes the hull of a closed mesh a shape, from the vertices that its triangles use. Returns 0 with
   an error message. */
static int demi_mesh_hull(dem_world *w, const char *call, const dem_mesh *mesh, demi_shape *shape) {
    const size_t count = (size_t)mesh->vertex_count;
    dem_real *points = (dem_real *)demi_alloc(w, 3*count, sizeof *points);
    unsigned char *taken = (unsigned char *)demi_alloc(w, count, 1);
    demi_closed c;
    int i, n = 0, made = 0;
    if (!demi_closed_find(w, mesh, &c) || !points || !taken) demi_no_memory(w, call);
    else if (demi_closed_body(w, call, &c)) {
        for (i = 0; i < 3*mesh->triangle_count; i++) {
            if (taken[c.corner[i]]) continue;
            taken[c.corner[i]] = 1;
            demi_put(points + 3*n++, demi_at(mesh->vertices + 3*c.corner[i]));
        }
        made = demi_polyhedron_of(w, call, n, points, shape);
    }
    demi_closed_free(w, &c);
    demi_free(w, points);
    demi_free(w, taken);
    return made;
}
#if !defined(DEM_NO_POLYHEDRA)
DEM_API dem_shape dem_shape_mesh_add(dem_world *w, const dem_mesh *mesh, dem_real dent) {
    demi_shape shape;
    dem_vec3 place = demi_v(0, 0, 0);
    dem_real most = 0;
    int i, k;
    if (demi_null(w, __func__, mesh, "mesh") || demi_shape_planar(w, __func__))
        return demi_no_shape;
    if (!(dent >= 0) || !demi_finite(dent)) {
        demi_refuse(w, __func__, "dent is %g m, must be >= 0 and finite", (double)dent);
        return demi_no_shape;
    }
    if (!demi_mesh_sound(w, __func__, mesh->vertex_count, mesh->vertices, 3, mesh->triangle_count,
                         mesh->triangles, 3)) return demi_no_shape;
    if (!demi_mesh_hull(w, __func__, mesh, &shape)) return demi_no_shape;
    for (i = 0; i < 3*mesh->triangle_count; i++) {      /* corners, midpoints of sides, centroids */
        const int32_t *t = mesh->triangles + i/3*3;
        dem_vec3 x[3], at[3];
        for (k = 0; k < 3; k++) x[k] = demi_at(mesh->vertices + 3*t[(i + k)%3]);
        at[0] = x[0];
        at[1] = demi_scale(demi_add(x[0], x[1]), DEM_R(0.5));
        at[2] = demi_scale(demi_add(demi_add(x[0], x[1]), x[2]), DEM_R(1)/3);
        for (k = 0; k < 3; k++) {
            const dem_real deep = demi_polyhedron_depth(&shape, at[k]);
            if (deep > most) { most = deep; place = at[k]; }
        }
    }
    if (most > dent + shape.radius*(DEMI_SINGLE ? DEM_R(2e-5) : DEM_R(1e-8))) {
        demi_refuse(w, __func__, "the mesh is not convex: at (%g, %g, %g) m it lies %.3g m inside "
                    "its hull, more than the allowed dent of %g m; cut it into convex pieces, use "
                    "a cluster of spheres, or increase dent to use the hull", (double)place.x,
                    (double)place.y, (double)place.z, (double)most, (double)dent);
        demi_shape_free(w, &shape);
        return demi_no_shape;
    }
    return demi_shape_adopt(w, __func__, &shape);
}
#endif

static size_t demi_shape_hull_reals(const demi_shape *s) {
    return 4*(size_t)s->faces + 3*(size_t)s->corners;
}
static size_t demi_shape_rim_ints(const demi_shape *s) {
    return (size_t)s->faces + 1 + (size_t)s->rim[s->faces];
}
/* Replaces the arrays of a shape by copies in another world. Returns 0 if memory ran out. */
static int demi_shape_copy(dem_world *to, demi_shape *shape) {
    const demi_shape from = *shape;
    const size_t parts = 4*(size_t)from.count, pieces = (size_t)from.pieces;
    shape->parts = 0;
    shape->piece = 0;
    shape->hull = 0;
    shape->rim = 0;
    if (parts) {
        shape->parts = (dem_real *)demi_hold(to, DEMI_SCENE, parts, sizeof(dem_real));
        if (shape->parts) memcpy(shape->parts, from.parts, parts*sizeof(dem_real));
    }
    if (pieces) {
        shape->piece = (demi_piece *)demi_hold(to, DEMI_SCENE, pieces, sizeof(demi_piece));
        if (shape->piece) memcpy(shape->piece, from.piece, pieces*sizeof(demi_piece));
    }
    if (from.faces) {
        const size_t reals = demi_shape_hull_reals(&from), ints = demi_shape_rim_ints(&from);
        shape->hull = (double *)demi_hold(to, DEMI_SCENE, reals, sizeof(double));
        shape->rim = (int32_t *)demi_hold(to, DEMI_SCENE, ints, sizeof(int32_t));
        if (shape->hull) memcpy(shape->hull, from.hull, reals*sizeof(double));
        if (shape->rim) memcpy(shape->rim, from.rim, ints*sizeof(int32_t));
    }
    if ((!parts || shape->parts) && (!pieces || shape->piece) &&
        (!from.faces || (shape->hull && shape->rim))) return 1;
    demi_shape_free(to, shape);
    return 0;
}

/* --- properties of polyhedra (DEMI_SHAPES) --- */

static dem_real demi_polyhedron_support(const demi_shape *s, dem_vec3 n) {
    const demi_d3 e = demi_d3_of(n);
    const double *x = s->hull + 4*s->faces;
    double far = -1e300;
    int i;
    for (i = 0; i < s->corners; i++, x += 3) far = DEMI_MAX(far, demi_d3_dot(e, demi_d3_at(x)));
    return (dem_real)far;
}
static dem_real demi_polyhedron_thin(const demi_part *p) { return p->shape->thin*p->scale; }
static double demi_polyhedron_equal(const demi_part *p) {
    return (double)(p->shape->equal*p->scale);
}
static double demi_polyhedron_curve(const demi_part *p, double h) {
    (void)h;
    return demi_polyhedron_equal(p);
}
/* The ellipsoid with the same moments of inertia. */
static dem_vec3 demi_polyhedron_drawn(const demi_part *p, dem_vec3 u) {
    return demi_product(demi_scale(demi_shape_alike(p->shape), p->scale), u);
}
/* Extent of a part from its centre along n (unit), m. */
static dem_real demi_part_support(const demi_part *p, dem_vec3 n) {
    if (p->kind == DEMI_BALL) return p->radius;
    return p->scale*demi_shape_rows[p->kind].support(p->shape, dem_quat_unrotate(p->q, n));
}
/* The unit normal of a face, in the frame of its shape. */
static dem_vec3 demi_face_normal(const demi_shape *s, int f) {
    const double *a = s->hull + 4*f;
    return demi_scale(demi_d3_real(demi_d3_at(a)), (dem_real)a[3]);
}
/* Largest separation of q from a face of p, m: a lower bound of their distance. */
static dem_real demi_faces_gap(const demi_part *p, const demi_part *q, dem_vec3 gap) {
    dem_real most = -DEM_R(1e30);
    int f;
    for (f = 0; p->kind == DEMI_POLYHEDRON && f < p->shape->faces; f++) {
        const dem_vec3 n = dem_quat_rotate(p->q, demi_face_normal(p->shape, f));
        const dem_real off = demi_dot(n, gap) - (dem_real)p->shape->hull[4*f + 3]*p->scale;
        if (off > most) most = DEMI_MAX(most, off - demi_part_support(q, demi_scale(n, -1)));
    }
    return most;
}
/* Lower bound, m, of the distance of two polyhedra, or of a polyhedron and another part. */
static dem_real demi_polyhedra_gap(const demi_part *p, const demi_part *q, dem_vec3 gap,
                                   dem_real enough) {
    const dem_real d = demi_length(gap), one = demi_faces_gap(p, q, gap);
    const dem_real two = demi_faces_gap(q, p, demi_scale(gap, -1)), most = DEMI_MAX(one, two);
    if (!(d > 0)) return -enough;
    return DEMI_MAX(most, d - p->radius - q->radius);
}

enum { DEMI_SECTION = 2*DEM_POLYHEDRON_FACES + 8 };     /* largest number of corners of a polygon */
/* Clips a convex polygon to n.(x - o) >= 0. Returns its number of corners. */
static int demi_polygon_clip(demi_d3 *x, int count, demi_d3 n, demi_d3 o) {
    demi_d3 out[DEMI_SECTION];
    double d[DEMI_SECTION];
    int i, less = 0, left = 0;
    for (i = 0; i < count; i++) {
        d[i] = demi_d3_dot(n, demi_d3_sub(x[i], o));
        less += d[i] < 0;
    }
    if (!less) return count;
    if (less == count) return 0;
    for (i = 0; i < count && left + 2 <= DEMI_SECTION; i++) {
        const int next = i + 1 < count ? i + 1 : 0;
        if (!(d[i] < 0)) out[left++] = x[i];
        if ((d[i] < 0) != (d[next] < 0))
            out[left++] = demi_d3_between(x[i], x[next], d[i]/(d[i] - d[next]));
    }
    memcpy(x, out, (size_t)left*sizeof *out);
    return left;
}
