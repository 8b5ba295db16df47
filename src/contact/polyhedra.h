/* ---------------------------------------------------------------------------------------------
   >>polyhedra
   What two convex polyhedra, or one and a rigid surface, share, and how that pushes them apart;
   geometry only. A polyhedron about O is pyramids over its faces with their tips in O; in that of
   face f, of height h_f and outward normal n_f,
       u(x) = 1 - n_f.(x - O)/h_f,         1 at O, 0 on the surface:
   how far in x lies, and the pressure there of an elastic body on a rigid core (a pressure field,
   [ELA19]). Where two overlap, the deeper inside one, the less inside the other; they meet in the
   surface S on which both u are the same. What they share is
       I = integral over both of the smaller u,             overlap = sqrt(I/((4 pi/3)^(1/3) R*))
   with R* of the spheres of their volumes. As A moves against B, only S counts, and that gives
       dI = integral over S of u dA n . (way of A's points), n unit, from A to B:
   forces and moments of the pressure u on S, equal and opposite, and the gradient of U(overlap):
   faces, edges and corners pass into each other without a jump, and energy is conserved. A cube on
   a plane or on its like has the overlap by which the two overlap. I itself follows from S: in each
   pyramid g = 1 - u is linear, and the field (x - O)(1/3 - g/4 - 1/(12 g^3)) has the divergence u
   and is 0 on the surface; over a triangle with g1, g2, g3 the mean of 1/g^3 is 1/(g1 g2 g3). (The
   law of the overlap's volume, [FEN12], conserves energy, too; but there a face that lies on
   another one is free to tilt.) A rigid wall has u without limit behind its surface, and S is that.
   --------------------------------------------------------------------------------------------- */

/* A polyhedron where it is now, about some origin, in some axes. */
typedef struct demi_solid {
    int faces, corners;
    const int32_t *rim;            /* faces + 1 starts, then the corners of each face */
    double centre[3];
    double plane[DEM_POLYHEDRON_FACES][4];     /* n/h, 1/m; h, m */
    double corner[DEMI_HULL_CORNERS][3];
} demi_solid;
static void demi_solid_of(const demi_part *p, dem_vec3 centre, demi_solid *s) {
    const demi_shape *shape = p->shape;
    const double *plane = shape->hull, *corner = shape->hull + 4*shape->faces;
    const double scale = (double)p->scale;
    double R[9];
    int i, k;
    demi_rotation_of(p->q, R);
    s->faces = shape->faces;
    s->corners = shape->corners;
    s->rim = shape->rim;
    s->centre[0] = (double)centre.x; s->centre[1] = (double)centre.y;
    s->centre[2] = (double)centre.z;
    for (i = 0; i < s->faces; i++, plane += 4) {
        for (k = 0; k < 3; k++) s->plane[i][k] = demi_dot3(R + 3*k, plane)/scale;
        s->plane[i][3] = plane[3]*scale;
    }
    for (i = 0; i < s->corners; i++, corner += 3)
        for (k = 0; k < 3; k++) s->corner[i][k] = s->centre[k] + scale*demi_dot3(R + 3*k, corner);
}
/* u of face f's pyramid at x. */
static double demi_solid_in(const demi_solid *s, int f, const double *x) {
    double d[3];
    demi_sub3(x, s->centre, d);
    return 1 - demi_dot3(s->plane[f], d);
}

/* --- pressure u, summed over pieces of S --- */

typedef struct demi_pressure {
    double shared;                 /* m3: I */
    double sum, at[3], wide[6];    /* of u dA: 1, x, x x (xx yy zz xy xz yz) */
    double force[3], torque[3];    /* of u dA: n; x cross n */
    double deep;                   /* largest u */
} demi_pressure;
/* A polygon of n corners x with its u; unit: normal of S; height: m, of the polygon over the
   centre, of a pair the sum of both. */
static void demi_pressure_polygon(demi_pressure *s, double (*x)[3], const double *u, int count,
                               const double *unit, double height) {
    static const int one[6] = {0, 1, 2, 0, 0, 1}, two[6] = {0, 1, 2, 1, 2, 2};
    double force = 0, at[3] = {0, 0, 0}, t[3];
    int i, k;
    for (i = 0; i < count; i++) s->deep = DEMI_MAX(s->deep, u[i]);
    for (i = 1; i + 1 < count; i++) {
        const double *a = x[0], *b = x[i], *c = x[i + 1];
        const double u0 = u[0], u1 = u[i], u2 = u[i + 1], all = u0 + u1 + u2;
        const double pairs = u0*u1 + u0*u2 + u1*u2, q = all - pairs + u0*u1*u2;
        double e[3], f[3], n[3], area;
        demi_sub3(b, a, e);
        demi_sub3(c, a, f);
        demi_cross3(e, f, n);
        area = fabs(demi_dot3(n, unit))/2;
        s->shared += area*height/12*(u0*u1*u2 - pairs + q*q/(1 - q));
        force += area*all/3;
        for (k = 0; k < 3; k++)
            at[k] += area/12*(all*(a[k] + b[k] + c[k]) + u0*a[k] + u1*b[k] + u2*c[k]);
        for (k = 0; k < 6; k++) {
            const int p = one[k], r = two[k];
            const double P = a[p] + b[p] + c[p], Q = a[r] + b[r] + c[r];
            s->wide[k] += area/60*(all*(P*Q + a[p]*a[r] + b[p]*b[r] + c[p]*c[r]) +
                Q*(u0*a[p] + u1*b[p] + u2*c[p]) + P*(u0*a[r] + u1*b[r] + u2*c[r]) +
                2*(u0*a[p]*a[r] + u1*b[p]*b[r] + u2*c[p]*c[r]));
        }
    }
    demi_cross3(at, unit, t);
    s->sum += force;
    for (k = 0; k < 3; k++) {
        s->at[k] += at[k];
        s->force[k] += force*unit[k];
        s->torque[k] += t[k];
    }
}
/* A point that stands for so much of S. */
static void demi_pressure_point(demi_pressure *s, const double *x, double u, double area,
                             const double *unit, double height) {
    static const int one[6] = {0, 1, 2, 0, 0, 1}, two[6] = {0, 1, 2, 1, 2, 2};
    const double f = area*u, g = 1 - u;
    double t[3];
    int k;
    s->deep = DEMI_MAX(s->deep, u);
    s->shared += area*height/12*u*u*(6 - 8*u + 3*u*u)/(g*g*g);
    s->sum += f;
    demi_cross3(x, unit, t);
    for (k = 0; k < 3; k++) {
        s->at[k] += f*x[k];
        s->force[k] += f*unit[k];
        s->torque[k] += f*t[k];
    }
    for (k = 0; k < 6; k++) s->wide[k] += f*x[one[k]]*x[two[k]];
}
static void demi_pressure_add(demi_pressure *s, const demi_pressure *more) {
    int k;
    s->shared += more->shared;
    s->sum += more->sum;
    for (k = 0; k < 3; k++) {
        s->at[k] += more->at[k];
        s->force[k] += more->force[k];
        s->torque[k] += more->torque[k];
    }
    for (k = 0; k < 6; k++) s->wide[k] += more->wide[k];
    s->deep = DEMI_MAX(s->deep, more->deep);
}
static void demi_pressure_scale(demi_pressure *s, double by) {
    int k;
    s->shared *= by;
    s->sum *= by;
    for (k = 0; k < 3; k++) {
        s->at[k] *= by;
        s->force[k] *= by;
        s->torque[k] *= by;
    }
    for (k = 0; k < 6; k++) s->wide[k] *= by;
}

/* --- sections: where a plane cuts a pyramid, or half spaces leave something of a polygon --- */

enum { DEMI_SECTION = 2*DEM_POLYHEDRON_FACES + 8 };
/* Where the plane level = 0 cuts the pyramid over face f: level at the centre, and at the corners
   of the face in their order. Answers how many corners there are. */
static int demi_pyramid_section(const demi_solid *s, int f, double centre, const double *level,
                                double (*x)[3]) {
    const int32_t *loop = s->rim + s->faces + 1 + s->rim[f];
    const int n = s->rim[f + 1] - s->rim[f], inside = centre > 0;
    int i, k, count = 0;
    for (i = 0; i < n; i++) {
        const int next = i + 1 < n ? i + 1 : 0;
        const double *a = s->corner[loop[i]], *b = s->corner[loop[next]];
        if ((level[i] > 0) != inside) {
            const double t = centre/(centre - level[i]);
            for (k = 0; k < 3; k++) x[count][k] = s->centre[k] + t*(a[k] - s->centre[k]);
            count++;
        }
        if ((level[i] > 0) != (level[next] > 0)) {
            const double t = level[i]/(level[i] - level[next]);
            for (k = 0; k < 3; k++) x[count][k] = a[k] + t*(b[k] - a[k]);
            count++;
        }
    }
    return count;
}
/* What is left of a convex polygon where n.(x - o) >= 0. */
static int demi_polygon_clip(double (*x)[3], int count, const double *n, const double *o) {
    double out[DEMI_SECTION][3], d[DEMI_SECTION], v[3];
    int i, k, less = 0, left = 0;
    for (i = 0; i < count; i++) {
        demi_sub3(x[i], o, v);
        d[i] = demi_dot3(n, v);
        less += d[i] < 0;
    }
    if (!less) return count;
    if (less == count) return 0;
    for (i = 0; i < count && left + 2 <= DEMI_SECTION; i++) {
        const int next = i + 1 < count ? i + 1 : 0;
        if (!(d[i] < 0)) memcpy(out[left++], x[i], sizeof *out);
        if ((d[i] < 0) == (d[next] < 0)) continue;
        for (k = 0; k < 3; k++)
            out[left][k] = x[i][k] + d[i]/(d[i] - d[next])*(x[next][k] - x[i][k]);
        left++;
    }
    memcpy(x, out, (size_t)left*sizeof *out);
    return left;
}
/* What is left of it in the pyramid over face f. */
static int demi_pyramid_clip(const demi_solid *s, int f, double (*x)[3], int count) {
    const int32_t *loop = s->rim + s->faces + 1 + s->rim[f];
    const int n = s->rim[f + 1] - s->rim[f];
    int i;
    for (i = 0; i < n && count > 2; i++) {
        double a[3], b[3], side[3];
        demi_sub3(s->corner[loop[i]], s->centre, a);
        demi_sub3(s->corner[loop[i + 1 < n ? i + 1 : 0]], s->centre, b);
        demi_cross3(a, b, side);
        count = demi_polygon_clip(x, count, side, s->centre);
    }
    return count;
}
/* How deep below a face each corner is, m. */
static void demi_solid_depths(const demi_solid *s, const demi_solid *other, int face, double *in) {
    int i;
    for (i = 0; i < s->corners; i++)
        in[i] = demi_solid_in(other, face, s->corner[i])*other->plane[face][3];
}
/* Leaves out faces all corners of which are deeper, or less deep, than at. */
static void demi_solid_leave(const demi_solid *s, const double *in, double at, int deeper,
                             unsigned char *alive) {
    const int32_t *loops = s->rim + s->faces + 1;
    int f, i;
    for (f = 0; f < s->faces; f++) {
        for (i = s->rim[f]; i < s->rim[f + 1]; i++)
            if ((in[loops[i]] > at) != deeper) break;
        if (i == s->rim[f + 1]) alive[f] = 0;
    }
}
/* Which faces of a and b may have a piece of S, to begin with all. Of b's faces, a's centre being
   beyond, that below which a comes least: none of a's that lie wholly beyond it, none of b's that
   lie wholly deeper than a comes. 0: some face keeps the two apart. */
static int demi_solid_alive(const demi_solid *a, const demi_solid *b, unsigned char *of_a,
                            unsigned char *of_b) {
    double in[DEMI_HULL_CORNERS], least = 1e300;
    int g, i, best = -1;
    for (g = 0; g < b->faces; g++) {
        double most = 0;
        if (demi_solid_in(b, g, a->centre) > 0) continue;
        for (i = 0; i < a->corners; i++) {
            const double u = demi_solid_in(b, g, a->corner[i]);
            most = DEMI_MAX(most, u);
        }
        if (!(most > 0)) return 0;
        if (!(most*b->plane[g][3] < least)) continue;
        least = most*b->plane[g][3];
        best = g;
    }
    if (best < 0) return 1;
    demi_solid_depths(a, b, best, in);
    demi_solid_leave(a, in, 0, 0, of_a);
    demi_solid_depths(b, b, best, in);
    demi_solid_leave(b, in, least*(1 + 1e-9), 1, of_b);
    return 1;
}
/* The piece of S between faces f and g. */
static void demi_solids_piece(const demi_solid *a, const demi_solid *b, int f, int g,
                              demi_pressure *s) {
    const int32_t *loop = a->rim + a->faces + 1 + a->rim[f];
    const int n = a->rim[f + 1] - a->rim[f];
    const double centre = demi_solid_in(b, g, a->centre) - 1;
    double x[DEMI_SECTION][3], u[DEMI_SECTION], level[DEM_POLYHEDRON_FACES], unit[3], to[3], size;
    int i, above = 0, count;
    for (i = 0; i < n; i++) above += (level[i] = demi_solid_in(b, g, a->corner[loop[i]])) > 0;
    if (above == (centre > 0 ? n : 0)) return;
    demi_sub3(a->plane[f], b->plane[g], unit);
    size = demi_unit3(unit);
    if (!(size*a->plane[f][3] > 1e-9)) return;  /* the same face */
    count = demi_pyramid_section(a, f, centre, level, x);
    count = demi_pyramid_clip(b, g, x, count);
    if (count < 3) return;
    for (i = 0; i < count; i++) u[i] = DEMI_MAX(demi_solid_in(a, f, x[i]), 0);
    demi_sub3(b->centre, a->centre, to);
    demi_pressure_polygon(s, x, u, count, unit, demi_dot3(to, unit));
}
/* Is x inside? */
static int demi_solid_holds(const demi_solid *s, const double *x) {
    int f;
    for (f = 0; f < s->faces; f++) if (!(demi_solid_in(s, f, x) > 0)) return 0;
    return 1;
}
/* The centre has gone through a surface: there is no pressure any more, but something that pushes
   back along n and, by its depth, stops the run. */
static void demi_pressure_beyond(const demi_solid *a, const double *n, demi_pressure *s) {
    const double h = a->plane[0][3];
    int k;
    s->deep = 2;
    if (s->shared > 0 && demi_dot3(s->force, s->force) > 1e-6*s->sum*s->sum) return;
    memset(s, 0, sizeof *s);
    s->deep = 2;
    s->shared = h*h*h;
    s->sum = h*h;
    for (k = 0; k < 3; k++) {
        s->force[k] = h*h*n[k];
        s->at[k] = s->sum*a->centre[k];
    }
    demi_cross3(a->centre, s->force, s->torque);
}
/* Polygons of a plane are prisms; where two end at one height there is a volume in which both u are
   those of the ends, the same, and S may pass through it anywhere, so that neither force nor energy
   is told. So one of the two is taken to be half as high again. Their centres are at z = 0. */
static void demi_solid_stretch(demi_solid *s) {
    int i;
    for (i = 0; i < s->corners; i++) s->corner[i][2] *= 1.5;
    for (i = 0; i < s->faces; i++) {
        s->plane[i][2] /= 1.5;
        s->plane[i][3] = 1/sqrt(demi_dot3(s->plane[i], s->plane[i]));
    }
}
/* All of S; 0: there is none. */
static int demi_solids_press(const demi_solid *a, const demi_solid *b, demi_pressure *s) {
    static const double up[3] = {0, 0, 1};
    unsigned char fs[DEM_POLYHEDRON_FACES], gs[DEM_POLYHEDRON_FACES];
    int f, g;
    memset(s, 0, sizeof *s);
    memset(fs, 1, sizeof fs);
    memset(gs, 1, sizeof gs);
    if (!demi_solid_alive(a, b, fs, gs) || !demi_solid_alive(b, a, gs, fs)) return 0;
    for (f = 0; f < a->faces; f++)
        for (g = 0; g < b->faces && fs[f]; g++) if (gs[g]) demi_solids_piece(a, b, f, g, s);
    if (demi_solid_holds(b, a->centre) || demi_solid_holds(a, b->centre))
        demi_pressure_beyond(a, up, s);
    return s->shared > 0 && s->sum > 0;
}
static int demi_double_order(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}
/* Part of the ray from o in direction (c, sn) that is inside a polygon across z which turns left
   (side 1) or right (-1): lo to hi, which come as its ends. */
static void demi_polygon_ray(double (*x)[3], int count, int side, const double *o, double c,
                             double sn, double *lo, double *hi) {
    int e;
    for (e = 0; e < count; e++) {
        const double *p = x[e], *q = x[e + 1 < count ? e + 1 : 0];
        const double u = side*(p[1] - q[1]), v = side*(q[0] - p[0]);
        const double over = u*(o[0] - p[0]) + v*(o[1] - p[1]), slope = u*c + v*sn;
        if (slope > 0) *lo = DEMI_MAX(*lo, -over/slope);
        else if (slope < 0) *hi = DEMI_MIN(*hi, -over/slope);
        else if (over < 0) *hi = -1;
    }
}
/* The polygon of face f's pyramid, across z, outside of a hole (x, y, radius): along rays from its
   middle, between those to corners and to where sides cross its rim. 0: nothing of it is in it. */
static int demi_pressure_round(demi_pressure *s, const demi_solid *a, int f, double (*x)[3],
                               int count, const double *unit, double height, const double *hole) {
    static const double at[4] = {0.06943184420297371, 0.33000947820757187, 0.6699905217924281,
                                 0.9305681557970263};
    static const double part[4] = {0.17392742256872692, 0.32607257743127307, 0.32607257743127307,
                                   0.17392742256872692};
    static const double on[3] = {0.1127016653792583, 0.5, 0.8872983346207417};
    static const double weight[3] = {5.0/18, 8.0/18, 5.0/18};
    double angle[3*DEMI_SECTION + 1], area = 0;
    int i, k, e, piece, angles = 0, left = 0, right = 0, near_by = 0;
    for (i = 0; i < count; i++) {
        const double *p = x[i], *q = x[i + 1 < count ? i + 1 : 0];
        const double u = p[0] - hole[0], v = p[1] - hole[1], du = q[0] - p[0], dv = q[1] - p[1];
        const double A = du*du + dv*dv, B = u*du + v*dv, C = u*u + v*v - hole[2]*hole[2];
        const double D = B*B - A*C, turn = u*dv - v*du;
        left += turn >= 0;
        right += turn <= 0;
        area += turn;
        near_by |= C < 0;
        angle[angles++] = demi_atan2(v, u);
        for (k = -1; k < 2 && A > 0 && D > 0; k += 2) {
            const double t = (-B + k*sqrt(D))/A;
            if (!(t > 0 && t < 1)) continue;
            near_by = 1;
            angle[angles++] = demi_atan2(v + t*dv, u + t*du);
        }
    }
    if (!near_by && left < count && right < count) return 0;    /* nor is its middle inside */
    qsort(angle, (size_t)angles, sizeof *angle, demi_double_order);
    angle[angles] = angle[0] + 2*DEMI_PI;
    for (i = 0; i < angles; i++) {
        const double width = angle[i + 1] - angle[i];
        const int pieces = 1 + (int)(width/0.4);
        for (piece = 0; piece < pieces && width > 1e-15; piece++)
            for (k = 0; k < 4; k++) {
                const double turn = angle[i] + (piece + at[k])*width/pieces;
                const double c = demi_cos(turn), sn = demi_sin(turn);
                double lo = hole[2], hi = 1e300;
                demi_polygon_ray(x, count, area > 0 ? 1 : -1, hole, c, sn, &lo, &hi);
                for (e = 0; e < 3 && hi > lo; e++) {
                    const double r = lo + on[e]*(hi - lo);
                    const double y[3] = {hole[0] + r*c, hole[1] + r*sn, x[0][2]};
                    const double dA = part[k]*width/pieces*weight[e]*(hi - lo)*r;
                    demi_pressure_point(s, y, DEMI_MAX(demi_solid_in(a, f, y), 0), dA, unit,
                                        height);
                }
            }
    }
    return 1;
}
/* S on a flat piece of a rigid wall: beyond n.x = at, n unit, into the wall; on that side of all
   planes (normal, a point of it) that bound it; hole: null, or x, y and radius of one in it,
   across z. Without bounds the polyhedron's centre must be on this side; a piece may be seen from
   behind, where it takes from what others share. */
static void demi_solid_on_flat(const demi_solid *a, const double *n, double at,
                               double (*sides)[2][3], int side_count, const double *hole,
                               demi_pressure *s) {
    const int32_t *loops = a->rim + a->faces + 1;
    const double centre = demi_dot3(n, a->centre) - at;
    double all[DEMI_HULL_CORNERS], x[DEMI_SECTION][3], u[DEMI_SECTION];
    double level[DEM_POLYHEDRON_FACES];
    int f, i, k, above = 0, count;
    if (centre > 0 && !side_count) { demi_pressure_beyond(a, n, s); return; }
    for (i = 0; i < a->corners; i++) above += (all[i] = demi_dot3(n, a->corner[i]) - at) > 0;
    if (above == (centre > 0 ? a->corners : 0)) return;
    for (f = 0; f < a->faces; f++) {
        for (i = a->rim[f], k = 0; i < a->rim[f + 1]; i++) level[k++] = all[loops[i]];
        count = demi_pyramid_section(a, f, centre, level, x);
        for (i = 0; i < side_count && count > 2; i++)
            count = demi_polygon_clip(x, count, sides[i][0], sides[i][1]);
        if (count < 3 || (hole && demi_pressure_round(s, a, f, x, count, n, -centre, hole)))
            continue;
        for (i = 0; i < count; i++) u[i] = DEMI_MAX(demi_solid_in(a, f, x[i]), 0);
        demi_pressure_polygon(s, x, u, count, n, -centre);
    }
}

/* --- the contact that a pressure is --- */

/* Where friction and damping act: four points about the centre of pressure that spread as wide as
   the pressure does, so that what lies on a face does not turn about one point. */
typedef struct demi_patch {
    dem_vec3 normal, point;        /* unit, a -> b; m: centre of pressure */
    dem_vec3 spread[2];            /* m: corners are at point +- one +- the other */
    dem_real couple;               /* m: moment about the normal over the force */
    double force;                  /* m2: of u */
} demi_patch;
/* Not where it does not push. The two directions of the spread: any, but the same from step to
   step. */
static int demi_pressure_patch(const demi_pressure *s, demi_patch *out) {
    static const double from[3] = {0.3301, 0.5563, 0.7626};
    const double *m = s->wide, F = sqrt(demi_dot3(s->force, s->force));
    double n[3], e[3], t[3], x[3], C[6], Ce[3], Ct[3], ee, tt, et, root, size, along;
    int k;
    if (!(F > 0)) return 0;
    for (k = 0; k < 3; k++) n[k] = s->force[k]/F;
    demi_cross3(n, s->torque, x);
    along = demi_dot3(n, s->at)/s->sum;
    for (k = 0; k < 3; k++) x[k] = x[k]/F + along*n[k];
    for (k = 0; k < 3; k++) C[k] = m[k]/s->sum - s->at[k]*s->at[k]/(s->sum*s->sum);
    C[3] = m[3]/s->sum - s->at[0]*s->at[1]/(s->sum*s->sum);
    C[4] = m[4]/s->sum - s->at[0]*s->at[2]/(s->sum*s->sum);
    C[5] = m[5]/s->sum - s->at[1]*s->at[2]/(s->sum*s->sum);
    demi_cross3(n, from, t);
    demi_unit3(t);
    demi_cross3(t, n, e);
    demi_sym_times(C, e, Ce);
    demi_sym_times(C, t, Ct);
    ee = DEMI_MAX(demi_dot3(e, Ce), 0);
    tt = DEMI_MAX(demi_dot3(t, Ct), 0);
    et = demi_dot3(e, Ct);
    root = sqrt(DEMI_MAX(ee*tt - et*et, 0));    /* the root of a 2 x 2 tensor, Cayley-Hamilton */
    size = sqrt(ee + tt + 2*root);
    if (!(size > 0)) size = 1;
    out->normal = demi_v((dem_real)n[0], (dem_real)n[1], (dem_real)n[2]);
    out->point = demi_v((dem_real)x[0], (dem_real)x[1], (dem_real)x[2]);
    for (k = 0; k < 3; k++) {
        Ce[k] = ((ee + root)*e[k] + et*t[k])/size;
        Ct[k] = (et*e[k] + (tt + root)*t[k])/size;
    }
    out->spread[0] = demi_v((dem_real)Ce[0], (dem_real)Ce[1], (dem_real)Ce[2]);
    out->spread[1] = demi_v((dem_real)Ct[0], (dem_real)Ct[1], (dem_real)Ct[2]);
    out->couple = (dem_real)(demi_dot3(n, s->torque)/F);
    out->force = F;
    return 1;
}
/* From the centre of pressure to corner k. Seen from the other body, whose normal is the opposite
   one, corner k is k ^ 1. */
static dem_vec3 demi_patch_spread(const demi_patch *p, int k) {
    const dem_vec3 one = demi_scale(p->spread[0], k & 2 ? DEM_R(-1) : DEM_R(1));
    return demi_add(one, demi_scale(p->spread[1], k & 1 ? DEM_R(-1) : DEM_R(1)));
}
/* sqrt(I/((4 pi/3)^(1/3) R*)), m; and how it grows where a force F (of u) gives way, per m. */
static double demi_shared_overlap(double shared, double r_eff) {
    return sqrt(shared/(DEMI_POLYHEDRON_SCALE*r_eff));
}
static double demi_shared_slope(double force, double r_eff, double overlap) {
    return force/(2*DEMI_POLYHEDRON_SCALE*r_eff*overlap);
}

/* --- points that are nearest --- */

/* The point q of a polyhedron nearest to x, and how far off it is, m; below 0 inside, where it is
   on the nearest face. */
static double demi_solid_near(const demi_solid *s, const double *x, double *q) {
    const int32_t *loops = s->rim + s->faces + 1;
    double inside = -1e300, least = 1e300, d[3];
    int f, i, k;
    for (f = 0; f < s->faces; f++) {
        const double *a = s->plane[f], size = sqrt(demi_dot3(a, a));
        double n[3], foot[3], off;
        int beyond = 0;
        demi_sub3(x, s->centre, d);
        off = (demi_dot3(a, d) - 1)/size;
        for (k = 0; k < 3; k++) {
            n[k] = a[k]/size;
            foot[k] = x[k] - off*n[k];
        }
        if (!(off > 0)) {
            if (off > inside && least > 1e299) {
                inside = off;
                memcpy(q, foot, sizeof foot);
            }
            continue;
        }
        for (i = s->rim[f]; i < s->rim[f + 1]; i++) {
            const double *b = s->corner[loops[i]];
            const double *c = s->corner[loops[i + 1 < s->rim[f + 1] ? i + 1 : s->rim[f]]];
            double e[3], out[3], to[3], at[3], t, l;
            demi_sub3(c, b, e);
            demi_cross3(e, n, out);
            demi_sub3(foot, b, to);
            if (!(demi_dot3(out, to) > 0)) continue;
            beyond = 1;
            t = demi_dot3(e, to)/demi_dot3(e, e);
            t = t < 0 ? 0 : t > 1 ? 1 : t;
            for (k = 0; k < 3; k++) at[k] = b[k] + t*e[k];
            demi_sub3(x, at, d);
            l = sqrt(demi_dot3(d, d));
            if (l < least) { least = l; memcpy(q, at, sizeof at); }
        }
        if (!beyond) { memcpy(q, foot, sizeof foot); return off; }
    }
    return least < 1e299 ? least : inside;
}
/* A polyhedron in the measure in which an ellipsoid at `at` is the unit sphere about the origin. */
static void demi_solid_measure(const demi_part *p, const demi_part *egg, dem_vec3 at,
                               demi_solid *s) {
    const double axes[3] = {(double)egg->axes.x, (double)egg->axes.y, (double)egg->axes.z};
    double R[9], v[3];
    int i, k, e;
    demi_solid_of(p, at, s);
    demi_rotation_of(egg->q, R);
    for (i = -1; i < s->corners; i++) {
        double *x = i < 0 ? s->centre : s->corner[i];
        memcpy(v, x, sizeof v);
        for (k = 0; k < 3; k++) x[k] = (R[k]*v[0] + R[3 + k]*v[1] + R[6 + k]*v[2])/axes[k];
    }
    for (i = 0; i < s->faces; i++) {
        memcpy(v, s->plane[i], sizeof v);
        for (k = 0; k < 3; k++)
            for (e = 0, s->plane[i][k] = 0; e < 3; e++) s->plane[i][k] += axes[k]*R[3*e + k]*v[e];
    }
}
/* How far a part reaches from its centre along n (unit), m. */
static dem_real demi_part_support(const demi_part *p, dem_vec3 n) {
    if (p->kind == DEMI_BALL) return p->radius;
    return p->scale*demi_shape_rows[p->kind].support(p->shape, dem_quat_unrotate(p->q, n));
}
/* The farthest that a face of p keeps q off: no more than their distance. */
static dem_real demi_faces_gap(const demi_part *p, const demi_part *q, dem_vec3 gap) {
    dem_real most = -DEM_R(1e30);
    int f;
    for (f = 0; p->kind == DEMI_POLYHEDRON && f < p->shape->faces; f++) {
        const double *a = p->shape->hull + 4*f;
        const dem_vec3 own = demi_scale(demi_v((dem_real)a[0], (dem_real)a[1], (dem_real)a[2]),
                                        (dem_real)a[3]);
        const dem_vec3 n = dem_quat_rotate(p->q, own);
        const dem_real off = demi_dot(n, gap) - demi_part_support(q, demi_scale(n, -1)) -
            (dem_real)a[3]*p->scale;
        most = DEMI_MAX(most, off);
    }
    return most;
}
/* Does the face of p that faces q's centre most keep all of q off? Most pairs that are apart are so
   by one of the two. */
static int demi_face_keeps(const demi_part *p, const demi_part *q, dem_vec3 gap) {
    const dem_vec3 own = dem_quat_unrotate(p->q, gap);
    const double e[3] = {(double)own.x, (double)own.y, (double)own.z}, scale = (double)p->scale;
    const double *face = p->shape->hull, *a = face;
    double most = -1e300;
    dem_vec3 n;
    int f;
    for (f = 0; f < p->shape->faces; f++, a += 4) {
        const double off = demi_dot3(a, e)*a[3] - scale*a[3];
        if (off > most) { most = off; face = a; }
    }
    n = demi_scale(demi_v((dem_real)face[0], (dem_real)face[1], (dem_real)face[2]),
                   (dem_real)face[3]);
    return (dem_real)most > demi_part_support(q, demi_scale(dem_quat_rotate(p->q, n), -1))*
        (1 + 16*(DEMI_SINGLE ? DEM_R(1e-7) : DEM_R(2e-16)));
}
static dem_real demi_polyhedra_gap(const demi_part *p, const demi_part *q, dem_vec3 gap,
                                   dem_real enough) {
    const dem_real d = demi_length(gap), one = demi_faces_gap(p, q, gap);
    const dem_real two = demi_faces_gap(q, p, demi_scale(gap, -1)), most = DEMI_MAX(one, two);
    if (!(d > 0)) return -enough;
    return DEMI_MAX(most, d - p->radius - q->radius);
}
