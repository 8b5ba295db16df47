/* ---------------------------------------------------------------------------------------------
   >>shapes
   Ellipsoids and rigid clusters of spheres: mass properties, support heights, contact of two
   ellipsoids (narrow phase). A shape is stored in its principal frame about its centre of mass, per
   unit of mass and scale. A body has a position, a quaternion and the radius of its bounding
   sphere, which determines its scale. Owns w->shapes; uses no material and no law.
   --------------------------------------------------------------------------------------------- */
DEM_API dem_quat dem_quat_about(dem_vec3 axis, dem_real angle) {
    const dem_vec3 e = demi_unit(axis);
    const dem_real s = (dem_real)demi_sin((double)angle/2);
    return dem_quat_make((dem_real)demi_cos((double)angle/2), s*e.x, s*e.y, s*e.z);
}
static dem_quat demi_quat_at(const dem_real *p) { return dem_quat_make(p[0], p[1], p[2], p[3]); }
static void demi_quat_put(dem_real *p, dem_quat q) {
    p[0] = q.w; p[1] = q.x; p[2] = q.y; p[3] = q.z;
}
static dem_quat demi_quat_conjugate(dem_quat q) { return dem_quat_make(q.w, -q.x, -q.y, -q.z); }
static int demi_quat_finite(dem_quat q) {
    return demi_finite(q.w) && demi_finite(q.x) && demi_finite(q.y) && demi_finite(q.z);
}
/* Returns the largest magnitude of a component. */
static double demi_quat_most(dem_quat q) {
    const double a = fabs((double)q.w), b = fabs((double)q.x), c = fabs((double)q.y);
    const double d = fabs((double)q.z), ab = DEMI_MAX(a, b), cd = DEMI_MAX(c, d);
    return DEMI_MAX(ab, cd);
}
/* Returns q normalised; q must not be 0. */
static dem_quat demi_quat_unit(dem_quat q) {
    const double most = demi_quat_most(q);      /* first: squares may be too large or small */
    const double w = (double)q.w/most, x = (double)q.x/most, y = (double)q.y/most;
    const double z = (double)q.z/most, l = sqrt(w*w + x*x + y*y + z*z);
    return dem_quat_make((dem_real)(w/l), (dem_real)(x/l), (dem_real)(y/l), (dem_real)(z/l));
}
/* Computes the matrix of a rotation, 3 x 3 by rows, in double precision. */
static void demi_rotation_of(dem_quat q, double *R) {
    const double w = (double)q.w, x = (double)q.x, y = (double)q.y, z = (double)q.z;
    R[0] = 1 - 2*(y*y + z*z); R[1] = 2*(x*y - w*z);     R[2] = 2*(x*z + w*y);
    R[3] = 2*(x*y + w*z);     R[4] = 1 - 2*(x*x + z*z); R[5] = 2*(y*z - w*x);
    R[6] = 2*(x*z - w*y);     R[7] = 2*(y*z + w*x);     R[8] = 1 - 2*(x*x + y*y);
}
/* Returns the quaternion of a rotation matrix (Shepperd). The largest component is computed first,
   so that no small number is a divisor. */
static dem_quat demi_quat_of(double R[3][3]) {
    const double t = R[0][0] + R[1][1] + R[2][2];
    double q[4];
    int i = 0, j, k;
    if (t > R[0][0] && t > R[1][1] && t > R[2][2]) {
        q[0] = 1 + t;
        q[1] = R[2][1] - R[1][2]; q[2] = R[0][2] - R[2][0]; q[3] = R[1][0] - R[0][1];
    } else {
        if (R[1][1] > R[i][i]) i = 1;
        if (R[2][2] > R[i][i]) i = 2;
        j = (i + 1)%3;
        k = (i + 2)%3;
        q[0] = R[k][j] - R[j][k];
        q[1 + i] = 1 + R[i][i] - R[j][j] - R[k][k];
        q[1 + j] = R[j][i] + R[i][j];
        q[1 + k] = R[k][i] + R[i][k];
    }
    return demi_quat_unit(dem_quat_make((dem_real)q[0], (dem_real)q[1], (dem_real)q[2],
                                        (dem_real)q[3]));
}

/* --- mass properties --- */

/* Diagonalises a symmetric matrix by Jacobi rotations: its diagonal receives the eigenvalues, the
   columns of E the eigenvectors. E is a rotation. */
static void demi_jacobi3(double M[3][3], double E[3][3]) {
    int i, j, k, sweep;
    for (i = 0; i < 3; i++) for (j = 0; j < 3; j++) E[i][j] = i == j;
    for (sweep = 0; sweep < 30; sweep++) {
        const double off = M[0][1]*M[0][1] + M[0][2]*M[0][2] + M[1][2]*M[1][2];
        const double all = M[0][0]*M[0][0] + M[1][1]*M[1][1] + M[2][2]*M[2][2];
        if (off <= 1e-30*all) return;
        for (i = 0; i < 2; i++)
            for (j = i + 1; j < 3; j++) {
                double t, c, s, theta;
                if (!(fabs(M[i][j]) > 0)) continue;
                theta = (M[j][j] - M[i][i])/(2*M[i][j]);
                t = (theta < 0 ? -1 : 1)/(fabs(theta) + sqrt(theta*theta + 1));
                c = 1/sqrt(t*t + 1);
                s = t*c;
                for (k = 0; k < 3; k++) {
                    const double a = M[k][i], b = M[k][j];
                    M[k][i] = c*a - s*b;
                    M[k][j] = s*a + c*b;
                }
                for (k = 0; k < 3; k++) {
                    const double a = M[i][k], b = M[j][k];
                    M[i][k] = c*a - s*b;
                    M[j][k] = s*a + c*b;
                }
                for (k = 0; k < 3; k++) {
                    const double a = E[k][i], b = E[k][j];
                    E[k][i] = c*a - s*b;
                    E[k][j] = s*a + c*b;
                }
            }
    }
}

/* A part of a body: a sphere of a cluster, a piece of a union, or the whole body. */
typedef struct demi_part {
    int kind;                      /* DEMI_BALL, ... */
    dem_real radius;               /* m, of the bounding sphere; of a sphere: its own */
    dem_vec3 centre;               /* m, from the body's centre */
    dem_vec3 axes;                 /* m, not of spheres: lengths with a meaning for each kind */
    dem_quat q;                    /* orientation, not of spheres */
    const demi_shape *shape;       /* not of spheres; multiply its lengths by scale */
    dem_real scale;
} demi_part;
/* Properties of a kind of part, and the gap between two. Contacts are in >>meets. */
typedef struct demi_shape_row {
    const char *name;
    dem_real (*support)(const demi_shape *s, dem_vec3 n);     /* m, how far along n (unit) */
    dem_real (*thin)(const demi_part *p);               /* m, smallest radius */
    double (*equal)(const demi_part *p);                /* m, radius of the sphere of its volume */
    double (*curve)(const demi_part *p, double h);      /* m, radius of curvature at height h */
    dem_vec3 (*drawn)(const demi_part *p, dem_vec3 u);  /* m, point of the drawn surface along u */
    dem_real (*gap)(const demi_part *p, const demi_part *q, dem_vec3 gap, dem_real enough);
    const char *touch;             /* functions for contacts with other kinds, see demi_listed */
} demi_shape_row;
#define DEMI_SHAPE_DECLARE(KIND, NAME, WORD, GAP, TOUCH) \
    static dem_real demi_##NAME##_support(const demi_shape *s, dem_vec3 n); \
    static dem_real demi_##NAME##_thin(const demi_part *p); \
    static double demi_##NAME##_equal(const demi_part *p); \
    static double demi_##NAME##_curve(const demi_part *p, double h); \
    static dem_vec3 demi_##NAME##_drawn(const demi_part *p, dem_vec3 u); \
    static dem_real GAP(const demi_part *p, const demi_part *q, dem_vec3 gap, dem_real enough);
DEMI_SHAPES(DEMI_SHAPE_DECLARE)
#define DEMI_SHAPE_ROW(KIND, NAME, WORD, GAP, TOUCH) \
    {WORD, demi_##NAME##_support, demi_##NAME##_thin, demi_##NAME##_equal, demi_##NAME##_curve, \
     demi_##NAME##_drawn, GAP, #TOUCH},
static const demi_shape_row demi_shape_rows[] = {DEMI_SHAPES(DEMI_SHAPE_ROW)};
static int demi_shape_kind(const demi_shape *shape) { return shape ? shape->kind : DEMI_BALL; }
/* Returns the "n" of the article in "an ellipsoid", or "". */
static const char *demi_an(const char *name) { return strchr("aeiou", name[0]) ? "n" : ""; }

/* Volume integrals over a body, about the origin: of 1, x y z, xx yy zz xy xz yz. */
typedef struct demi_moments { double one, x[3], xx[6]; } demi_moments;
/* Adds a piece of volume v with its centre at c. own: m2, its mean square extent along an axis. */
static void demi_moments_add(demi_moments *m, double v, const double *c, double own) {
    int k;
    m->one += v;
    for (k = 0; k < 3; k++) {
        m->x[k] += v*c[k];
        m->xx[k] += v*(c[k]*c[k] + own);
    }
    m->xx[3] += v*c[0]*c[1];
    m->xx[4] += v*c[0]*c[2];
    m->xx[5] += v*c[1]*c[2];
}
/* Adds the union of a cluster's spheres, so that overlaps count once: by rays along x through the
   centres of rays x rays cells of their outline. Along a ray the union of intervals is exact. With
   512 rays the error is a few 1e-6 for three spheres. room: two doubles per sphere. */
static void demi_moments_union(const demi_shape *shape, int rays, double *room, demi_moments *m) {
    double lo[2], hi[2], step[2];
    int i, j, k, e, n;
    lo[0] = lo[1] = 1e300;
    hi[0] = hi[1] = -1e300;
    for (i = 0; i < shape->count; i++)
        for (e = 0; e < 2; e++) {
            const double c = (double)shape->parts[4*i + 1 + e], r = (double)shape->parts[4*i + 3];
            lo[e] = DEMI_MIN(lo[e], c - r);
            hi[e] = DEMI_MAX(hi[e], c + r);
        }
    for (e = 0; e < 2; e++) step[e] = (hi[e] - lo[e])/rays;
    for (j = 0; j < rays; j++)
        for (k = 0; k < rays; k++) {
            double c[3], from, to;
            c[1] = lo[0] + (j + 0.5)*step[0];
            c[2] = lo[1] + (k + 0.5)*step[1];
            for (i = n = 0; i < shape->count; i++) {     /* intervals, insertion sort */
                const double y = c[1] - (double)shape->parts[4*i + 1];
                const double z = c[2] - (double)shape->parts[4*i + 2];
                const double r = (double)shape->parts[4*i + 3], h = r*r - y*y - z*z;
                if (h <= 0) continue;
                from = (double)shape->parts[4*i] - sqrt(h);
                to = (double)shape->parts[4*i] + sqrt(h);
                for (e = n++; e > 0 && room[2*e - 2] > from; e--) {
                    room[2*e] = room[2*e - 2];
                    room[2*e + 1] = room[2*e - 1];
                }
                room[2*e] = from;
                room[2*e + 1] = to;
            }
            for (i = 0; i < n; i = e) {
                from = room[2*i];
                to = room[2*i + 1];
                for (e = i + 1; e < n && room[2*e] <= to; e++) to = DEMI_MAX(to, room[2*e + 1]);
                c[0] = (from + to)/2;
                demi_moments_add(m, (to - from)*step[0]*step[1], c, 0);
                m->xx[0] += step[0]*step[1]*(to - from)*(to - from)*(to - from)/12;
                m->xx[1] += (to - from)*step[0]*step[1]*step[0]*step[0]/12;
                m->xx[2] += (to - from)*step[0]*step[1]*step[1]*step[1]/12;
            }
        }
}

/* Computes a shape's volume, centre of mass, principal frame and moments of inertia per mass. */
static void demi_shape_principal(demi_shape *shape, const demi_moments *m) {
    double M[3][3], E[3][3], c[3], trace, I[6];
    int i, k;
    shape->volume = m->one;
    for (k = 0; k < 3; k++) c[k] = m->x[k]/m->one;
    shape->centre = demi_v((dem_real)c[0], (dem_real)c[1], (dem_real)c[2]);
    for (k = 0; k < 6; k++) I[k] = m->xx[k]/m->one;
    for (k = 0; k < 3; k++) I[k] -= c[k]*c[k];
    I[3] -= c[0]*c[1]; I[4] -= c[0]*c[2]; I[5] -= c[1]*c[2];
    M[0][0] = I[0]; M[1][1] = I[1]; M[2][2] = I[2];
    M[0][1] = M[1][0] = I[3]; M[0][2] = M[2][0] = I[4]; M[1][2] = M[2][1] = I[5];
    trace = I[0] + I[1] + I[2];                 /* second moments -> moments of inertia */
    for (i = 0; i < 3; i++)                     /* round-off must not rotate the frame */
        for (k = 0; k < 3; k++) if (i != k && fabs(M[i][k]) < 1e-12*trace) M[i][k] = 0;
    demi_jacobi3(M, E);
    shape->inertia = demi_v((dem_real)(trace - M[0][0]), (dem_real)(trace - M[1][1]),
                           (dem_real)(trace - M[2][2]));
    shape->frame = demi_quat_of(E);
}

/* Sets the bounds of a cluster for contact detection and the time step: bounding radius, largest
   lever arm of a contact force, smallest radius (thin), radius of the flattest point (blunt), and
   smallest effective mass over mass (light): 1/g over (l/h)^2, with g = n.K n of this body alone, l
   the radius of equal volume and h the support height. */
static void demi_cluster_bounds(demi_shape *shape) {
    const dem_vec3 I = shape->inertia;
    const double least = (double)DEMI_MIN(I.x, DEMI_MIN(I.y, I.z));
    int i;
    shape->radius = shape->moment_arm = shape->blunt = 0;
    shape->thin = shape->parts[3];
    for (i = 0; i < shape->count; i++) {
        const dem_real l = demi_length(demi_at(shape->parts + 4*i)), r = shape->parts[4*i + 3];
        shape->radius = DEMI_MAX(shape->radius, l + r);
        shape->moment_arm = DEMI_MAX(shape->moment_arm, l);
        shape->thin = DEMI_MIN(shape->thin, r);
        shape->blunt = DEMI_MAX(shape->blunt, r);
    }
    shape->light = 1/(1 + (double)shape->moment_arm*(double)shape->moment_arm/least);
}
/* The same for an ellipsoid. */
static void demi_ellipsoid_bounds(demi_shape *shape) {
    const double I[3] = {(double)shape->inertia.x, (double)shape->inertia.y,
                         (double)shape->inertia.z};
    const double a[3] = {(double)shape->axes.x, (double)shape->axes.y, (double)shape->axes.z};
    const double l = demi_cube_root(a[0]*a[1]*a[2]);
    int i, k, j;
    shape->radius = (dem_real)DEMI_MAX(a[0], DEMI_MAX(a[1], a[2]));
    shape->thin = (dem_real)DEMI_MIN(a[0], DEMI_MIN(a[1], a[2]));
    shape->moment_arm = shape->radius - shape->thin;
    shape->blunt = (dem_real)(l*l*l)/(shape->thin*shape->thin);
    shape->light = 1;
    for (k = 0; k < 3; k++)                     /* normals in the three principal planes */
        for (i = 0; i <= 64; i++) {
            const double n0 = demi_cos(DEMI_PI/2*i/64), n1 = demi_sin(DEMI_PI/2*i/64);
            const double u = a[k], v = a[(k + 1)%3], h = sqrt(n0*n0*u*u + n1*n1*v*v);
            const double arm = n0*n1*(u*u - v*v)/h;
            j = (k + 2)%3;
            shape->light = DEMI_MIN(shape->light, h*h/(l*l)/(1 + arm*arm/I[j]));
        }
}

/* Frees the arrays of a shape. */
static void demi_shape_free(dem_world *w, demi_shape *shape) {
    demi_free(w, shape->parts);
    demi_free(w, shape->piece);
    demi_free(w, shape->hull);
    demi_free(w, shape->rim);
}
/* Returns 1 with an error message if contacts of a new kind with some shape are not available. */
static int demi_shapes_strange(dem_world *w, const char *call, int kind) {
    int i, other;
    for (i = -1; i <= w->shape_count; i++) {
        other = i < 0 ? DEMI_BALL : i < w->shape_count ? w->shapes[i].kind : kind;
        if (demi_listed(demi_shape_rows[DEMI_MAX(kind, other)].touch, DEMI_MIN(kind, other)))
            continue;
        demi_refuse(w, call, "contacts between shape %d, a%s %s, and shape %d, a%s %s, are not "
                    "available, so a world can hold only one of the two; nothing was added",
                    w->shape_count + 1, demi_an(demi_shape_rows[kind].name),
                    demi_shape_rows[kind].name, i + 1, demi_an(demi_shape_rows[other].name),
                    demi_shape_rows[other].name);
        return 1;
    }
    return 0;
}
/* Adds a prepared shape to the world and takes over its arrays; frees them if that fails. */
static dem_shape demi_shape_adopt(dem_world *w, const char *call, demi_shape *shape) {
    dem_shape id = demi_no_shape;
    if (demi_shapes_strange(w, call, shape->kind)) { demi_shape_free(w, shape); return id; }
    if (!demi_grow(w, DEMI_SCENE, &w->shapes, sizeof *w->shapes, (size_t)w->shape_count + 1)) {
        demi_shape_free(w, shape);
        demi_no_memory(w, call);
        return id;
    }
    if (!(shape->equal > 0))                    /* polygons have set theirs */
        shape->equal = (dem_real)demi_cube_root(shape->volume*3/(4*DEMI_PI));
    w->shapes[w->shape_count++] = *shape;
    demi_built(w, call);
    id.id = w->shape_count;
    return id;
}
/* Returns 1 with an error message in a planar world, which has no shapes of three dimensions. */
static int demi_shape_planar(dem_world *w, const char *call) {
    if (!w->desc.planar) return 0;
    demi_refuse(w, call, "the world is planar and holds only discs and polygons; set planar to 0, "
                "or use discs and dem_shape_polygon_add");
    return 1;
}

DEM_API dem_shape dem_shape_ellipsoid_add(dem_world *w, dem_vec3 a) {
    if (demi_null(w, __func__, w, "world")) return demi_no_shape;
    demi_shape shape;
    const double lo = (double)DEMI_MIN(a.x, DEMI_MIN(a.y, a.z));
    const double hi = (double)DEMI_MAX(a.x, DEMI_MAX(a.y, a.z));
    if (demi_shape_planar(w, __func__)) return demi_no_shape;
    if (!demi_finite3(a) || !(lo > 0) || !(hi <= 1000.001*lo)) {
        demi_refuse(w, __func__, "semi-axes are %g, %g and %g m, must be > 0 and "
                    "the longest at most 1000 times the shortest; give half lengths, in metres",
                    (double)a.x, (double)a.y, (double)a.z);
        return demi_no_shape;
    }
    memset(&shape, 0, sizeof shape);
    shape.kind = DEMI_ELLIPSOID;
    shape.axes = a;
    shape.volume = 4*DEMI_PI/3*(double)a.x*(double)a.y*(double)a.z;
    shape.inertia = demi_v((a.y*a.y + a.z*a.z)/5, (a.x*a.x + a.z*a.z)/5, (a.x*a.x + a.y*a.y)/5);
    shape.frame = dem_quat_make(1, 0, 0, 0);
    demi_ellipsoid_bounds(&shape);
    return demi_shape_adopt(w, __func__, &shape);
}

/* True if no two spheres of a cluster overlap, so that no volume counts twice. */
static int demi_cluster_apart(const demi_shape *shape) {
    int i, j;
    for (i = 0; i < shape->count; i++)
        for (j = i + 1; j < shape->count; j++) {
            const dem_real sum = shape->parts[4*i + 3] + shape->parts[4*j + 3];
            const dem_vec3 d = demi_sub(demi_at(shape->parts + 4*j), demi_at(shape->parts + 4*i));
            if (demi_dot(d, d) < sum*sum*DEM_R(0.999999)) return 0;
        }
    return 1;
}
/* Computes the moments of a cluster as its desc requires. Returns 0 if memory ran out. ([MIL] gives
   its tetrahedra the inertia of a sphere, and updates spins without the gyroscopic term.) */
static int demi_cluster_moments(dem_world *w, const dem_cluster_desc *desc, const demi_shape *shape,
                                demi_moments *m) {
    int i, k;
    memset(m, 0, sizeof *m);
    if (desc->mass == DEM_CLUSTER_GIVEN) {
        const double v = (double)desc->volume, c[3] = {(double)desc->centre.x,
            (double)desc->centre.y, (double)desc->centre.z};
        const double half = (double)(desc->inertia[0] + desc->inertia[1] + desc->inertia[2])/2;
        demi_moments_add(m, v, c, 0);
        for (k = 0; k < 3; k++) m->xx[k] += half - (double)desc->inertia[k];
        for (k = 3; k < 6; k++) m->xx[k] -= (double)desc->inertia[k];
        return 1;
    }
    if (desc->mass == DEM_CLUSTER_SUM || demi_cluster_apart(shape)) {
        for (i = 0; i < shape->count; i++) {
            const double r = (double)shape->parts[4*i + 3], v = 4*DEMI_PI/3*r*r*r;
            double c[3];
            for (k = 0; k < 3; k++) c[k] = (double)shape->parts[4*i + k];
            demi_moments_add(m, v, c, r*r/5);
        }
        return 1;
    } else {
        const size_t n = 2*(size_t)shape->count;
        double *room = (double *)demi_alloc(w, n, sizeof(double));
        if (!room) return 0;
        demi_moments_union(shape, desc->rays > 0 ? desc->rays : 512, room, m);
        demi_free(w, room);
        return 1;
    }
}
/* Returns 0 with an error message if the desc of a cluster is not allowed. */
static int demi_cluster_check(dem_world *w, const dem_cluster_desc *desc) {
    const char *call = "dem_shape_cluster_add";
    const dem_real *I = desc->inertia;
    int i;
    if (desc->count < 1 || desc->count > 1000 || !desc->positions || desc->rays < 0 ||
        desc->rays > 4096 || (desc->rays > 0 && desc->rays < 16)) {
        demi_refuse(w, call, "count is %d and rays is %d; count must be 1 to 1000 with positions "
                    "(count x 3), rays 0 or 16 to 4096", desc->count, desc->rays);
        return 0;
    }
    for (i = 0; i < desc->count; i++) {
        const dem_real r = desc->radii ? desc->radii[i] : desc->radius;
        if (demi_finite(r) && r > 0 && demi_place(demi_at(desc->positions + 3*i))) continue;
        demi_refuse(w, call, "sphere %d has radius %g m at (%g, %g, %g) m; the radius must be > 0 "
                    "and finite, coordinates at most 1e15 m; fill in radii or radius", i, (double)r,
                    (double)desc->positions[3*i], (double)desc->positions[3*i + 1],
                    (double)desc->positions[3*i + 2]);
        return 0;
    }
    if ((int)desc->mass < 0 || desc->mass > DEM_CLUSTER_GIVEN) {
        demi_refuse(w, call, "mass is %d, must be a DEM_CLUSTER_ value; start from "
                    "DEM_CLUSTER_DESC", (int)desc->mass);
        return 0;
    }
    if (desc->mass != DEM_CLUSTER_GIVEN) return 1;
    if (desc->volume > 0 && demi_finite(desc->volume) && demi_place(desc->centre) && I[0] > 0 &&
        I[1] > 0 && I[2] > 0 && I[0] <= I[1] + I[2] && I[1] <= I[0] + I[2] && I[2] <= I[0] + I[1] &&
        demi_finite(I[3]) && demi_finite(I[4]) && demi_finite(I[5]) &&
        demi_finite(I[0] + I[1] + I[2])) return 1;
    demi_refuse(w, call, "volume is %g m3, moments are %g, %g, %g m5 (per density); all must be > "
                "0, no moment above the sum of the other two, and the centre within 1e15 m",
                (double)desc->volume, (double)I[0], (double)I[1], (double)I[2]);
    return 0;
}
/* Returns 1 with an error message if the rays are so far apart that they may miss a sphere. */
static int demi_cluster_coarse(dem_world *w, const dem_cluster_desc *desc, const demi_shape *shape,
                               dem_real least) {
    const int rays = desc->rays > 0 ? desc->rays : 512;
    double side = 0;
    int i, j, e;
    if (desc->mass != DEM_CLUSTER_UNION || demi_cluster_apart(shape)) return 0;
    for (i = 0; i < shape->count; i++)
        for (j = 0; j < shape->count; j++)
            for (e = 1; e < 3; e++) {
                const double to = (double)(shape->parts[4*i + e] + shape->parts[4*i + 3]);
                side = DEMI_MAX(side, to - (double)(shape->parts[4*j + e] - shape->parts[4*j + 3]));
            }
    if (side/rays <= (double)least/4) return 0;
    demi_refuse(w, "dem_shape_cluster_add", "rays is %d, so rays are %.3g m apart, more than a "
                "quarter of the smallest radius, %g m; set rays to %.0f or more, at most 4096, or "
                "give the moments", rays, side/rays, (double)least, ceil(4*side/(double)least));
    return 1;
}
DEM_API dem_shape dem_shape_cluster_add(dem_world *w, const dem_cluster_desc *desc) {
    if (demi_null(w, __func__, desc, "desc")) return demi_no_shape;
    demi_shape shape;
    demi_moments m;
    dem_shape none;
    dem_vec3 about = demi_v(0, 0, 0);
    dem_real least = DEMI_SINGLE ? DEM_R(FLT_MAX) : (dem_real)DBL_MAX, most;
    int i;
    none.id = 0;
    if (demi_shape_planar(w, __func__) || !demi_cluster_check(w, desc)) return none;
    memset(&shape, 0, sizeof shape);
    shape.kind = DEMI_BALL;
    shape.count = desc->count;
    shape.parts = (dem_real *)demi_hold(w, DEMI_SCENE, 4*(size_t)shape.count, sizeof(dem_real));
    if (!shape.parts) { demi_no_memory(w, __func__); return none; }
    /* relative to the first sphere, for precision */
    if (desc->mass != DEM_CLUSTER_GIVEN) about = demi_at(desc->positions);
    for (i = 0; i < shape.count; i++) {
        demi_put(shape.parts + 4*i, demi_sub(demi_at(desc->positions + 3*i), about));
        shape.parts[4*i + 3] = desc->radii ? desc->radii[i] : desc->radius;
        least = DEMI_MIN(least, shape.parts[4*i + 3]);
    }
    if (demi_cluster_coarse(w, desc, &shape, least)) { demi_shape_free(w, &shape); return none; }
    if (!demi_cluster_moments(w, desc, &shape, &m)) {
        demi_shape_free(w, &shape);
        demi_no_memory(w, __func__);
        return none;
    }
    demi_shape_principal(&shape, &m);
    most = DEMI_MAX(shape.inertia.x, DEMI_MAX(shape.inertia.y, shape.inertia.z));
    if (!(shape.inertia.x > 0 && shape.inertia.y > 0 && shape.inertia.z > 0) ||
        2*most > (shape.inertia.x + shape.inertia.y + shape.inertia.z)*DEM_R(1.00001)) {
        demi_shape_free(w, &shape);
        demi_refuse(w, __func__, "a principal moment of inertia is not > 0, or above the "
                    "sum of the other two; %s",
                    desc->mass == DEM_CLUSTER_GIVEN ? "the given off-diagonal moments are too large"
                    : "use more rays");
        return none;
    }
    for (i = 0; i < shape.count; i++)
        demi_put(shape.parts + 4*i,
                 dem_quat_unrotate(shape.frame, demi_sub(demi_at(shape.parts + 4*i),
                                                                        shape.centre)));
    shape.lone = shape.count == 1 && !(demi_length(demi_at(shape.parts)) > 0);
    shape.centre = demi_add(shape.centre, about);
    demi_cluster_bounds(&shape);
    return demi_shape_adopt(w, __func__, &shape);
}

/* Returns the index of a shape, or -1 with an error message. */
static int demi_shape_index(dem_world *w, const char *call, dem_shape shape) {
    if (shape.id >= 1 && shape.id <= w->shape_count) return shape.id - 1;
    demi_refuse(w, call, "shape %d does not exist, there are %d; add it with "
                "dem_shape_ellipsoid_add and the like and check the id that this returns",
                (int)shape.id, w->shape_count);
    return -1;
}
/* Returns the semi-axes, m, of the ellipsoid with the same moments of inertia. */
static dem_vec3 demi_shape_alike(const demi_shape *s) {
    const dem_vec3 I = s->inertia;
    if (s->kind == DEMI_ELLIPSOID && !s->pieces) return s->axes;
    return demi_v(DEMI_SQRT(DEM_R(2.5)*DEMI_MAX(I.y + I.z - I.x, 0)),
                  DEMI_SQRT(DEM_R(2.5)*DEMI_MAX(I.x + I.z - I.y, 0)),
                  DEMI_SQRT(DEM_R(2.5)*DEMI_MAX(I.x + I.y - I.z, 0)));
}
DEM_API dem_result dem_shape_get(const dem_world *world, dem_shape shape, dem_shape_info *info) {
    if (demi_null_look(world, __func__, info, "info")) return DEM_ERROR_ARGUMENT;
    const int i = demi_shape_index((dem_world *)world, __func__, shape);
    const demi_shape *s;
    if (i < 0) return DEM_ERROR_ARGUMENT;
    s = &world->shapes[i];
    info->spheres = s->count;
    info->corners = s->corners;
    info->faces = s->faces;
    info->volume = (dem_real)s->volume;
    info->centre = s->centre;
    info->frame = s->frame;
    info->inertia = demi_scale(s->inertia, (dem_real)s->volume);
    info->semi_axes = demi_shape_alike(s);
    info->radius = s->radius;
    info->pieces = s->pieces;
    return DEM_OK;
}

/* --- a body and its shape --- */

DEM_INLINE const demi_shape *demi_shape_of(const dem_world *w, int body) {  /* null: a sphere */
    return w->bodies.shape && w->bodies.shape[body] ? &w->shapes[w->bodies.shape[body] - 1] : 0;
}
/* True if pairs see a body as a lone sphere: it is a sphere or, with springs, a cluster of one
   sphere, which differs from it only by its moments of inertia and an orientation. */
DEM_INLINE int demi_lone(const dem_world *w, int body) {
    const demi_shape *shape = demi_shape_of(w, body);
    return !shape || (shape->lone && demi_response_is(w, DEMI_PRESSING));
}
DEM_INLINE dem_real demi_scale_of(const dem_world *w, int body, const demi_shape *shape) {
    return demi_radius(w, body)/shape->radius;
}
/* Principal moments: precomputed per mass and scale for shapes, analytic for spheres and discs. */
static dem_vec3 demi_moments_of(const dem_world *w, int body) {        /* kg m2, principal */
    const demi_shape *shape = demi_shape_of(w, body);
    const double m = (double)w->bodies.mass[body], r = (double)demi_radius(w, body);
    dem_real one;
    if (shape) {
        one = demi_scale_of(w, body, shape);
        return demi_scale(shape->inertia, (dem_real)m*one*one);
    }
    one = (dem_real)(w->desc.planar ? m*r*r/2 : 0.4*m*r*r);
    return demi_v(one, one, one);
}
/* Returns the angular momentum of a body, from its spin at the full step, world frame, kg m2/s. */
static dem_vec3 demi_angular_of(const dem_world *w, int body) {
    const dem_vec3 I = demi_moments_of(w, body), spin = demi_at(w->bodies.spin + 4*body);
    dem_quat q;
    dem_vec3 own;
    if (!demi_shape_of(w, body)) return demi_scale(spin, I.x);
    q = demi_quat_at(w->bodies.orient + 4*body);
    own = dem_quat_unrotate(q, spin);
    return dem_quat_rotate(q, demi_v(I.x*own.x, I.y*own.y, I.z*own.z));
}
/* Returns the support height of a body in direction n (unit): its extent from its centre, m. */
static dem_real demi_support(const dem_world *w, int body, dem_vec3 n) {
    const demi_shape *shape = demi_shape_of(w, body);
    dem_real scale, far = -1;
    dem_vec3 e;
    int i;
    if (!shape) return demi_radius(w, body);
    scale = demi_scale_of(w, body, shape);
    e = dem_quat_unrotate(demi_quat_at(w->bodies.orient + 4*body), n);
    for (i = 0; i < shape->pieces; i++) {
        const demi_piece *piece = shape->piece + i;
        const demi_shape *one = &w->shapes[piece->shape];
        const dem_real s = demi_dot(piece->at, e) +
            demi_shape_rows[one->kind].support(one, dem_quat_unrotate(piece->q, e));
        far = i && far > s ? far : s;
    }
    if (!shape->count && !shape->pieces) far = demi_shape_rows[shape->kind].support(shape, e);
    for (i = 0; i < shape->count; i++) {
        const dem_real s = demi_dot(demi_at(shape->parts + 4*i), e) + shape->parts[4*i + 3];
        far = i && far > s ? far : s;
    }
    return scale*far;
}

/* --- contact of two ellipsoids. Perram and Wertheim's function [PW85] of two ellipsoids
         (x - xA).QA^-1 (x - xA) <= 1, Q = R diag(a^2, b^2, c^2) R^T, r = xB - xA, 0 < l < 1:
             K = (1 - l) QA + l QB,  s = K^-1 r,  f(l) = l (1 - l) r.s
       has one maximum, W0^2. Scaled by W0 the two touch at xA + (1 - l) QA s, with the normal
       s/|s|. There fA = (1 - l)^2 s.QA s and fB = l^2 s.QB s are equal. We solve ln(fA/fB)/2 = 0 by
       Newton's method, with slope -C ((1 - l)/fA + l/fB), C = s.QA K^-1 QB s, kept in a bracket.
       Any f(l) > 1 shows that the two are apart. No inverse of Q appears, so needles and discs are
       safe. The method of [RUB15] 3.2, shrinking both by W until they separate, ends at exactly
       this point and normal; its line V2 V3 has the direction QA K^-1 QB s. Test: "quartic and
       eigenvectors of [RUB15] converge to the same contact". --- */
/* A symmetric matrix, and a product with it. */
typedef struct demi_sym { double xx, yy, zz, xy, xz, yz; } demi_sym;
DEM_INLINE demi_d3 demi_sym_times(demi_sym Q, demi_d3 x) {
    return demi_d(Q.xx*x.x + Q.xy*x.y + Q.xz*x.z, Q.xy*x.x + Q.yy*x.y + Q.yz*x.z,
                  Q.xz*x.x + Q.yz*x.y + Q.zz*x.z);
}
/* Q of an ellipsoid, m2. */
DEM_INLINE demi_sym demi_ellipsoid_matrix(dem_quat q, dem_vec3 axes) {
    const double w = (double)q.w, x = (double)q.x, y = (double)q.y, z = (double)q.z;
    const double A = (double)axes.x*(double)axes.x, B = (double)axes.y*(double)axes.y;
    const double C = (double)axes.z*(double)axes.z;
    const demi_d3 R = demi_d(1 - 2*(y*y + z*z), 2*(x*y - w*z), 2*(x*z + w*y));
    const demi_d3 S = demi_d(2*(x*y + w*z), 1 - 2*(x*x + z*z), 2*(y*z - w*x));
    const demi_d3 T = demi_d(2*(x*z - w*y), 2*(y*z + w*x), 1 - 2*(x*x + y*y));
    demi_sym Q;
    Q.xx = A*R.x*R.x + B*R.y*R.y + C*R.z*R.z;
    Q.yy = A*S.x*S.x + B*S.y*S.y + C*S.z*S.z;
    Q.zz = A*T.x*T.x + B*T.y*T.y + C*T.z*T.z;
    Q.xy = A*R.x*S.x + B*R.y*S.y + C*R.z*S.z;
    Q.xz = A*R.x*T.x + B*R.y*T.y + C*R.z*T.z;
    Q.yz = A*S.x*T.x + B*S.y*T.y + C*S.z*T.z;
    return Q;
}
/* Returns sqrt(r.Q r): the support height of an ellipsoid along r, times the length of r. */
DEM_INLINE double demi_sym_height(demi_sym Q, demi_d3 r) {
    return sqrt(demi_d3_dot(r, demi_sym_times(Q, r)));
}
/* Returns an initial lambda: exact for spheres and for equal, parallel ellipsoids. */
DEM_INLINE double demi_meet_start(double ha, double hb) {
    return ha + hb > 0 ? ha/(ha + hb) : 0.5;
}
typedef struct demi_meet {
    double l, f, fa, fb;           /* lambda; the function; scaled distances squared */
    demi_d3 s, a, v;               /* s, QA s, K^-1 QB s */
    double u, C, step;             /* (fA - fB)/(fA + fB); C; the step of l that Newton's method
                                      takes from here */
    int iterations;
} demi_meet;
/* Evaluates the function at m->l: an iteration. */
DEM_INLINE void demi_meet_at(demi_sym A, demi_sym B, demi_d3 r, demi_meet *m) {
    const double l = m->l;
    demi_sym K, J;
    demi_d3 b;
    double per, u;
    K.xx = (1 - l)*A.xx + l*B.xx; K.yy = (1 - l)*A.yy + l*B.yy; K.zz = (1 - l)*A.zz + l*B.zz;
    K.xy = (1 - l)*A.xy + l*B.xy; K.xz = (1 - l)*A.xz + l*B.xz; K.yz = (1 - l)*A.yz + l*B.yz;
    J.xx = K.yy*K.zz - K.yz*K.yz; J.xy = K.yz*K.xz - K.xy*K.zz; J.xz = K.xy*K.yz - K.xz*K.yy;
    J.yy = K.xx*K.zz - K.xz*K.xz; J.yz = K.xy*K.xz - K.xx*K.yz; J.zz = K.xx*K.yy - K.xy*K.xy;
    per = 1/(K.xx*J.xx + K.xy*J.xy + K.xz*J.xz);   /* K^-1 = per J, by cofactors */
    m->s = demi_d3_scale(demi_sym_times(J, r), per);
    m->f = l*(1 - l)*demi_d3_dot(r, m->s);
    m->a = demi_sym_times(A, m->s);
    b = demi_sym_times(B, m->s);
    m->fa = (1 - l)*(1 - l)*demi_d3_dot(m->s, m->a);
    m->fb = l*l*demi_d3_dot(m->s, b);
    m->v = demi_d3_scale(demi_sym_times(J, b), per);
    m->u = u = (m->fa - m->fb)/(m->fa + m->fb);
    m->C = demi_d3_dot(m->a, m->v);
    /* ln(fa/fb)/2 = atanh u, which is about u (15 - 4 u^2)/(15 - 9 u^2) */
    m->step = u*(15 - 4*u*u)*m->fa*m->fb/
        ((15 - 9*u*u)*m->C*((1 - l)*m->fb + l*m->fa));
}
/* Takes the last step without another evaluation: s follows ds/dl = K^-1 (QA - QB) s =
   (s - v)/(1 - l), v = K^-1 QB s, and f its series to second order, f' = fA - fB, f'' = -2 C. The
   error is of the order of the step squared. */
DEM_INLINE void demi_meet_finish(demi_sym A, demi_meet *m) {
    const double rate = m->step/(1 - m->l);
    m->f += ((m->fa - m->fb) - m->C*m->step)*m->step;
    m->s = demi_d3_plus(m->s, rate, demi_d3_sub(m->s, m->v));
    m->l += m->step;
    m->fa = m->fb = m->f;
    m->a = demi_sym_times(A, m->s);
}
/* Tolerance for |fA - fB|/(fA + fB). It costs no more than a larger one. Normals are accurate to
   1e-10 at an aspect ratio of 2, and to 4e-6 at worst, at 100. */
#define DEMI_MEET_NEAR 1e-4
/* Finds the maximum of f from m->l on, by Newton's method on ln(fA/fB) within the bracket lo, hi,
   until fA and fB agree to `near`. Ends early once f > enough: the two are then apart. */
static void demi_meet_solve(demi_sym A, demi_sym B, demi_d3 r, double enough, double near,
                            demi_meet *m) {
    double lo = 0, hi = 1;
    for (m->iterations = 1;; m->iterations++) {
        demi_meet_at(A, B, r, m);
        if (m->f > enough || !(m->fa + m->fb > 0)) return;
        if (m->u > 0) lo = m->l; else hi = m->l;
        if (fabs(m->u) < near || m->iterations >= 100 || hi - lo < 1e-15) {
            demi_meet_finish(A, m);
            return;
        }
        m->l += m->step;
        if (!(m->l > lo && m->l < hi)) m->l = (lo + hi)/2;
    }
}
/* Computes the unit normal and the support heights of both ellipsoids along it, m. */
static void demi_meet_heights(const demi_meet *m, demi_d3 *n, double *ha, double *hb) {
    const double l = demi_d3_length(m->s);
    *n = demi_d3_over(m->s, l);
    *ha = sqrt(m->fa)/((1 - m->l)*l);
    *hb = sqrt(m->fb)/(m->l*l);
}
/* Returns the overlap of [RUB15] 3.2, m: the length of the line V2 V3 inside both ellipsoids. It
   leaves A at the larger root of (x + t d).QA^-1 (x + t d) = 1, and enters B at the smaller one. */
static double demi_meet_chord(const demi_meet *m, demi_sym A) {
    const demi_d3 d = demi_sym_times(A, m->v);
    const demi_d3 u = demi_d3_over(demi_d3_sub(m->s, demi_d3_scale(m->v, m->l)), 1 - m->l);
    const double ds = demi_d3_dot(d, m->s), dv = demi_d3_dot(d, m->v), du = demi_d3_dot(d, u);
    double out, in;
    if (!(m->f < 1)) return 0;
    out = (-(1 - m->l)*ds + sqrt((1 - m->l)*(1 - m->l)*ds*ds + dv*(1 - m->fa)))/dv;
    in = (m->l*ds - sqrt(m->l*m->l*ds*ds + du*(1 - m->fb)))/du;
    return (out - in)*demi_d3_length(d);
}
DEM_API dem_ellipsoid_contact dem_ellipsoids_contact_get(const dem_ellipsoid *a,
                                                         const dem_ellipsoid *b,
                                                         dem_real lambda) {
    dem_ellipsoid_contact out = {0, 0, {0, 0, 0}, {0, 0, 0}, 0, 0, 0, 0};
    if (!a || !b) return out;
    const dem_quat none = dem_quat_make(1, 0, 0, 0);
    const dem_quat qa = demi_quat_most(a->orientation) > 0 ? demi_quat_unit(a->orientation) : none;
    const dem_quat qb = demi_quat_most(b->orientation) > 0 ? demi_quat_unit(b->orientation) : none;
    const dem_vec3 gap = demi_sub(b->position, a->position);
    const demi_sym A = demi_ellipsoid_matrix(qa, a->semi_axes);
    const demi_sym B = demi_ellipsoid_matrix(qb, b->semi_axes);
    demi_d3 r = demi_d3_of(gap), n;
    double ha, hb, w0;
    demi_meet m;
    if (!(demi_d3_square(r) > 0)) {             /* centres coincide: take any direction */
        r.z = 1e-12*((double)a->semi_axes.z + (double)b->semi_axes.z);
    }
    m.l = lambda > 0 && lambda < 1 ? (double)lambda
        : demi_meet_start(demi_sym_height(A, r), demi_sym_height(B, r));
    demi_meet_solve(A, B, r, 1e300, 1e-12, &m);
    demi_meet_heights(&m, &n, &ha, &hb);
    w0 = sqrt(m.f);
    out.scale = (dem_real)w0;
    out.lambda = (dem_real)m.l;
    out.iterations = m.iterations;
    out.normal = demi_d3_real(n);
    out.point = demi_add(a->position, demi_d3_real(demi_d3_scale(m.a, 1 - m.l)));
    out.depth_normal = (dem_real)((1 - w0)*(ha + hb));
    out.depth_chord = (dem_real)demi_meet_chord(&m, A);
    out.depth_conservative = (dem_real)((1 - w0)*
        (demi_cube_root((double)a->semi_axes.x*(double)a->semi_axes.y*(double)a->semi_axes.z) +
         demi_cube_root((double)b->semi_axes.x*(double)b->semi_axes.y*(double)b->semi_axes.z)));
    return out;
}

/* --- parts of bodies, and how far apart they are --- */

/* Returns the number of parts of a body; 1 for a sphere. */
static int demi_parts_count(const dem_world *w, int body) {
    const demi_shape *shape = demi_shape_of(w, body);
    return !shape ? 1 : shape->count ? shape->count : shape->pieces ? shape->pieces : 1;
}
/* Writes the part of a body with a shape to p. demi_part_of corrects it for clusters and unions;
   all other shapes have one part. */
DEM_INLINE void demi_part_single(const dem_world *w, int body, const demi_shape *shape,
                                 demi_part *p) {
    p->kind = shape->kind;
    p->radius = demi_radius(w, body);
    p->centre = demi_v(0, 0, 0);
    p->scale = demi_scale_of(w, body, shape);
    p->axes = demi_scale(shape->axes, p->scale);
    p->q = demi_quat_at(w->bodies.orient + 4*body);
    p->shape = shape;
}
/* Returns part k of a body in its present orientation, computed from its quaternion. */
static demi_part demi_part_of(const dem_world *w, int body, int k) {
    const demi_shape *shape = demi_shape_of(w, body);
    demi_part p;
    if (shape) {
        demi_part_single(w, body, shape, &p);
        if (shape->count) {
            p.centre = demi_scale(dem_quat_rotate(p.q, demi_at(shape->parts + 4*k)), p.scale);
            p.radius = shape->parts[4*k + 3]*p.scale;
            p.axes = demi_v(0, 0, 0);
        } else if (shape->pieces) {
            const demi_piece *piece = shape->piece + k;
            p.shape = &w->shapes[piece->shape];
            p.kind = p.shape->kind;
            p.centre = demi_scale(dem_quat_rotate(p.q, piece->at), p.scale);
            p.q = dem_quat_multiply(p.q, piece->q);
            p.radius = p.shape->radius*p.scale;
            p.axes = demi_scale(p.shape->axes, p.scale);
        }
        return p;
    }
    memset(&p, 0, sizeof p);
    p.kind = DEMI_BALL;
    p.radius = demi_radius(w, body);
    return p;
}
/* Returns the rotated spheres of a cluster: rows of centre (from the body's) and radius, m. */
static const dem_real *demi_centres_of(const dem_world *w, int body) {
    return w->bodies.centre + 4*w->bodies.centre_start[body];
}
/* Half axes of an ellipsoid, m; those of a sphere are equal. */
DEM_INLINE dem_vec3 demi_part_axes(const demi_part *p) {
    return p->kind == DEMI_BALL ? demi_v(p->radius, p->radius, p->radius) : p->axes;
}
/* Q of an ellipsoid or a sphere, m2. */
static demi_sym demi_part_matrix(const demi_part *p) {
    return demi_ellipsoid_matrix(p->q, demi_part_axes(p));
}
/* --- properties of spheres and ellipsoids (DEMI_SHAPES) --- */

static dem_real demi_ball_support(const demi_shape *s, dem_vec3 n) { (void)n; return s->radius; }
static dem_real demi_ball_thin(const demi_part *p) { return p->radius; }
static double demi_ball_equal(const demi_part *p) { return (double)p->radius; }
static double demi_ball_curve(const demi_part *p, double h) { (void)h; return (double)p->radius; }
static dem_vec3 demi_ball_drawn(const demi_part *p, dem_vec3 u) { return demi_scale(u, p->radius); }
static dem_real demi_ellipsoid_support(const demi_shape *s, dem_vec3 n) {
    return demi_length(demi_product(n, s->axes));
}
static dem_real demi_ellipsoid_thin(const demi_part *p) {
    return DEMI_MIN(p->axes.x, DEMI_MIN(p->axes.y, p->axes.z));
}
static double demi_ellipsoid_equal(const demi_part *p) {
    return (double)(p->shape->equal*p->scale);
}
/* Gaussian radius of curvature, a b c/h^2. */
static double demi_ellipsoid_curve(const demi_part *p, double h) {
    return (double)p->axes.x*(double)p->axes.y*(double)p->axes.z/(h*h);
}
static dem_vec3 demi_ellipsoid_drawn(const demi_part *p, dem_vec3 u) {
    return demi_product(p->axes, u);
}
static dem_real demi_part_thin(const demi_part *p) { return demi_shape_rows[p->kind].thin(p); }
static double demi_part_equal(const demi_part *p) { return demi_shape_rows[p->kind].equal(p); }
/* Returns the radius for the stiffness of a contact, m. A stiffness that changes while the two roll
   would create or lose energy (Hertz: 1 % per collision at aspect ratio 3), so the conservative
   overlap uses the radius of equal volume. */
static double demi_part_round(const dem_world *w, const demi_part *p, double h) {
    return w->desc.ellipsoid_overlap == DEM_OVERLAP_CONSERVATIVE ? demi_part_equal(p)
        : demi_shape_rows[p->kind].curve(p, h);
}

/* The same as demi_part_of, but takes spheres of clusters from the rotated centres. */
DEM_INLINE demi_part demi_part_now(const dem_world *w, int body, int k) {
    const demi_shape *shape = demi_shape_of(w, body);
    demi_part p;
    const dem_real *sphere;
    if (shape && !shape->count) return demi_part_of(w, body, k);
    sphere = shape ? demi_centres_of(w, body) + 4*k : w->bodies.pos + 4*body;
    p.kind = DEMI_BALL;
    p.centre = shape ? demi_at(sphere) : demi_v(0, 0, 0);
    p.radius = sphere[3];
    p.axes = demi_v(0, 0, 0);
    p.q = dem_quat_make(1, 0, 0, 0);
    p.shape = shape;
    p.scale = 1;
    return p;
}
static dem_real demi_balls_gap(const demi_part *p, const demi_part *q, dem_vec3 gap,
                               dem_real enough) {
    (void)enough;
    return demi_length(gap) - p->radius - q->radius;
}
/* Returns the gap, m, of two ellipsoids, or of an ellipsoid and a sphere. */
static dem_real demi_ellipsoids_gap(const demi_part *p, const demi_part *q, dem_vec3 gap,
                                    dem_real enough) {
    const demi_sym A = demi_part_matrix(p), B = demi_part_matrix(q);
    const demi_d3 r = demi_d3_of(gap);
    double ha, hb;
    demi_d3 n;
    demi_meet m;
    if (!(demi_length(gap) > 0)) return -enough;
    m.l = demi_meet_start(demi_sym_height(A, r), demi_sym_height(B, r));
    demi_meet_solve(A, B, r, 1e300, DEMI_MEET_NEAR, &m);
    demi_meet_heights(&m, &n, &ha, &hb);
    return (dem_real)((sqrt(m.f) - 1)*(ha + hb));
}
/* Returns a lower bound of the distance between two parts, m; gap leads from centre to centre. May
   return -`enough` if the centres coincide. */
static dem_real demi_parts_gap(const demi_part *p, const demi_part *q, dem_vec3 gap,
                               dem_real enough) {
    return demi_shape_rows[DEMI_MAX(p->kind, q->kind)].gap(p, q, gap, enough);
}
/* The same for two bodies; shift leads from b to its image nearest to a. */
static dem_real demi_bodies_gap(const dem_world *w, int a, int b, const dem_real *shift,
                                dem_real enough) {
    const dem_vec3 r = demi_add(demi_sub(demi_at(w->bodies.pos + 4*b),
                                         demi_at(w->bodies.pos + 4*a)), demi_at(shift));
    const dem_real d = demi_length(r), rb = demi_radius(w, b);
    const int na = demi_parts_count(w, a), nb = demi_parts_count(w, b);
    dem_real least = enough;
    int i, j;
    if (d > 0) {
        const dem_vec3 n = demi_scale(r, 1/d);
        const dem_real first = d - demi_support(w, a, n) - demi_support(w, b, demi_scale(n, -1));
        if (first >= enough) return first;
    }
    for (i = 0; i < na; i++) {
        const demi_part p = demi_part_now(w, a, i);
        const dem_vec3 to = demi_sub(r, p.centre);
        if (na > 1 && demi_length(to) - p.radius - rb >= least) continue;
        for (j = 0; j < nb; j++) {
            const demi_part q = demi_part_now(w, b, j);
            least = DEMI_MIN(least, demi_parts_gap(&p, &q, demi_add(to, q.centre), least));
        }
    }
    return least;
}
