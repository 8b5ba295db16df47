/* ---------------------------------------------------------------------------------------------
   >>polyhedra
   Common volume of two convex polyhedra, or of one and a rigid surface, and the contact force that
   follows from it: geometry only. A polyhedron about O consists of pyramids over its faces with
   their apexes in O. In that of face f, of height h_f and outward normal n_f,
       u(x) = 1 - n_f.(x - O)/h_f,         1 at O, 0 on the surface
   is the relative depth of x. It is taken as the pressure at x, that of an elastic body on a rigid
   core (a pressure field, [ELA19]). If two polyhedra overlap, points deeper inside one are less
   deep inside the other. The surface S on which both u are equal separates them. From
       I = integral over both of the smaller u,             overlap = sqrt(I/((4 pi/3)^(1/3) R*))
   where R* is that of spheres of the same volumes. As A moves relative to B, only S contributes:
       dI = integral over S of u dA n . (displacement of A's points), n unit, from A to B.
   The forces and moments of the pressure u on S are therefore equal and opposite, and they are the
   gradient of U(overlap): energy is conserved, and contacts of faces, edges and corners pass into
   each other without a jump. A cube that lies on a plane or on a cube has an overlap equal to the
   depth of penetration. I follows from S as well: in each pyramid g = 1 - u is linear, and the
   field (x - O)(1/3 - g/4 - 1/(12 g^3)) has the divergence u and is 0 on the surface; over a
   triangle with g1, g2, g3 the mean of 1/g^3 is 1/(g1 g2 g3). (The law of the overlap's volume,
   [FEN12], conserves energy too, but there a face that lies on another one is free to tilt.) Behind
   the surface of a rigid wall u is infinite, and S is that surface.
   --------------------------------------------------------------------------------------------- */

/* A polyhedron in its present position and orientation, in some frame. */
typedef struct demi_solid {
    int faces, corners;
    const int32_t *rim;            /* faces + 1 starts, then the corners of each face */
    demi_d3 centre;
    struct { demi_d3 slope; double high; } face[DEM_POLYHEDRON_FACES];  /* n/h, 1/m; h, m */
    demi_d3 corner[DEMI_HULL_CORNERS];
} demi_solid;
/* Returns the number of corner i of a face, rim[f] <= i <= rim[f + 1]; the first follows the
   last. */
DEM_INLINE int32_t demi_solid_number(const demi_solid *s, int f, int i) {
    return s->rim[s->faces + 1 + (i < s->rim[f + 1] ? i : s->rim[f])];
}
DEM_INLINE demi_d3 demi_solid_corner(const demi_solid *s, int f, int i) {
    return s->corner[demi_solid_number(s, f, i)];
}
/* Sets s to polyhedron p with its centre at `centre`. */
static void demi_solid_of(const demi_part *p, dem_vec3 centre, demi_solid *s) {
    const demi_shape *shape = p->shape;
    const double *plane = shape->hull, *corner = shape->hull + 4*shape->faces;
    const double scale = (double)p->scale;
    double R[9];
    int i;
    demi_rotation_of(p->q, R);
    s->faces = shape->faces;
    s->corners = shape->corners;
    s->rim = shape->rim;
    s->centre = demi_d3_of(centre);
    for (i = 0; i < s->faces; i++, plane += 4) {
        s->face[i].slope = demi_d3_over(demi_d3_rotate(R, demi_d3_at(plane)), scale);
        s->face[i].high = plane[3]*scale;
    }
    for (i = 0; i < s->corners; i++, corner += 3)
        s->corner[i] = demi_d3_plus(s->centre, scale, demi_d3_rotate(R, demi_d3_at(corner)));
}
/* u at x in the pyramid of face f. */
static double demi_solid_in(const demi_solid *s, int f, demi_d3 x) {
    return 1 - demi_d3_dot(s->face[f].slope, demi_d3_sub(x, s->centre));
}

/* --- pressure u, summed over pieces of S --- */

/* Integrals of the pressure u over the surface S. */
typedef struct demi_pressure {
    double shared;                 /* m3: I */
    double sum, wide[6];           /* m2, m4: integrals over S of u, u x x (xx yy zz xy xz yz) */
    demi_d3 at, force, torque;     /* integrals over S of u x, u n, u x cross n */
    double deep;                   /* largest u */
} demi_pressure;
/* Adds a polygon of `count` corners x in the pyramid of face f. unit: normal of S; height: m, of
   the polygon above the centre, for a pair the sum of both. */
static void demi_pressure_polygon(demi_pressure *s, const demi_solid *body, int f, const demi_d3 *x,
                                  int count, demi_d3 unit, double height) {
    double force = 0, at[3] = {0, 0, 0}, a[3], b[3], c[3], u[DEMI_SECTION];
    int i, k;
    for (i = 0; i < count; i++) {
        u[i] = DEMI_MAX(demi_solid_in(body, f, x[i]), 0);
        s->deep = DEMI_MAX(s->deep, u[i]);
    }
    demi_d3_put(a, x[0]);
    for (i = 1; i + 1 < count; i++) {
        const double u0 = u[0], u1 = u[i], u2 = u[i + 1], all = u0 + u1 + u2;
        const double pairs = u0*u1 + u0*u2 + u1*u2, q = all - pairs + u0*u1*u2;
        const double area = fabs(demi_d3_dot(demi_d3_normal(x[0], x[i], x[i + 1]), unit))/2;
        demi_d3_put(b, x[i]);
        demi_d3_put(c, x[i + 1]);
        s->shared += area*height/12*(u0*u1*u2 - pairs + q*q/(1 - q));
        force += area*all/3;
        for (k = 0; k < 3; k++)
            at[k] += area/12*(all*(a[k] + b[k] + c[k]) + u0*a[k] + u1*b[k] + u2*c[k]);
        for (k = 0; k < 6; k++) {
            const int p = demi_sym_row[k], r = demi_sym_column[k];
            const double P = a[p] + b[p] + c[p], Q = a[r] + b[r] + c[r];
            s->wide[k] += area/60*(all*(P*Q + a[p]*a[r] + b[p]*b[r] + c[p]*c[r]) +
                Q*(u0*a[p] + u1*b[p] + u2*c[p]) + P*(u0*a[r] + u1*b[r] + u2*c[r]) +
                2*(u0*a[p]*a[r] + u1*b[p]*b[r] + u2*c[p]*c[r]));
        }
    }
    s->sum += force;
    s->at = demi_d3_add(s->at, demi_d3_at(at));
    s->force = demi_d3_plus(s->force, force, unit);
    s->torque = demi_d3_add(s->torque, demi_d3_cross(demi_d3_at(at), unit));
}
/* Adds a point of S that represents an area. */
static void demi_pressure_point(demi_pressure *s, const demi_solid *body, int face, demi_d3 x,
                                double area, demi_d3 unit, double height) {
    const double u = DEMI_MAX(demi_solid_in(body, face, x), 0), f = area*u, g = 1 - u;
    double y[3];
    int k;
    s->deep = DEMI_MAX(s->deep, u);
    s->shared += area*height/12*u*u*(6 - 8*u + 3*u*u)/(g*g*g);
    s->sum += f;
    s->at = demi_d3_plus(s->at, f, x);
    s->force = demi_d3_plus(s->force, f, unit);
    s->torque = demi_d3_plus(s->torque, f, demi_d3_cross(x, unit));
    demi_d3_put(y, x);
    for (k = 0; k < 6; k++) s->wide[k] += f*y[demi_sym_row[k]]*y[demi_sym_column[k]];
}
static void demi_pressure_add(demi_pressure *s, const demi_pressure *more) {
    int k;
    s->shared += more->shared;
    s->sum += more->sum;
    s->at = demi_d3_add(s->at, more->at);
    s->force = demi_d3_add(s->force, more->force);
    s->torque = demi_d3_add(s->torque, more->torque);
    for (k = 0; k < 6; k++) s->wide[k] += more->wide[k];
    s->deep = DEMI_MAX(s->deep, more->deep);
}
static void demi_pressure_scale(demi_pressure *s, double by) {
    int k;
    s->shared *= by;
    s->sum *= by;
    s->at = demi_d3_scale(s->at, by);
    s->force = demi_d3_scale(s->force, by);
    s->torque = demi_d3_scale(s->torque, by);
    for (k = 0; k < 6; k++) s->wide[k] *= by;
}

/* --- sections: a plane through a pyramid, and polygons clipped by half spaces --- */

typedef struct demi_half { demi_d3 n, o; } demi_half;  /* n.(x - o) >= 0 */
/* Cuts the pyramid over face f with the plane level = 0. centre, level: levels at the centre and at
   the corners of the face in their order. Returns the number of corners of the section. */
static int demi_pyramid_section(const demi_solid *s, int f, double centre, const double *level,
                                demi_d3 *x) {
    const int first = s->rim[f], n = s->rim[f + 1] - first, inside = centre > 0;
    int i, count = 0;
    for (i = 0; i < n; i++) {
        const double next = level[i + 1 < n ? i + 1 : 0];
        const demi_d3 a = demi_solid_corner(s, f, first + i);
        if ((level[i] > 0) != inside)
            x[count++] = demi_d3_between(s->centre, a, centre/(centre - level[i]));
        if ((level[i] > 0) != (next > 0))
            x[count++] = demi_d3_between(a, demi_solid_corner(s, f, first + i + 1),
                                         level[i]/(level[i] - next));
    }
    return count;
}
/* Clips a polygon to the pyramid over face f. */
static int demi_pyramid_clip(const demi_solid *s, int f, demi_d3 *x, int count) {
    int i;
    for (i = s->rim[f]; i < s->rim[f + 1] && count > 2; i++) {
        const demi_d3 side = demi_d3_normal(s->centre, demi_solid_corner(s, f, i),
                                            demi_solid_corner(s, f, i + 1));
        count = demi_polygon_clip(x, count, side, s->centre);
    }
    return count;
}
/* Depth of each corner of s below a face of the other, m. */
static void demi_solid_depths(const demi_solid *s, const demi_solid *other, int face, double *in) {
    int i;
    for (i = 0; i < s->corners; i++)
        in[i] = demi_solid_in(other, face, s->corner[i])*other->face[face].high;
}
/* Excludes faces whose corners are all deeper (or all less deep) than `at`. */
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
/* Excludes faces of a and b that cannot have a piece of S. Of b's faces with a's centre outside, it
   chooses the one below which a is least deep. Faces of a entirely outside it, and faces of b
   entirely deeper than a, are excluded. Returns 0 if some face separates the two. */
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
        if (!(most*b->face[g].high < least)) continue;
        least = most*b->face[g].high;
        best = g;
    }
    if (best < 0) return 1;
    demi_solid_depths(a, b, best, in);
    demi_solid_leave(a, in, 0, 0, of_a);
    demi_solid_depths(b, b, best, in);
    demi_solid_leave(b, in, least*(1 + 1e-9), 1, of_b);
    return 1;
}
/* Adds the piece of S between faces f and g. */
static void demi_solids_piece(const demi_solid *a, const demi_solid *b, int f, int g,
                              demi_pressure *s) {
    const int n = a->rim[f + 1] - a->rim[f];
    const double centre = demi_solid_in(b, g, a->centre) - 1;
    double level[DEM_POLYHEDRON_FACES];
    demi_d3 x[DEMI_SECTION], unit;
    int i, above = 0, count;
    for (i = 0; i < n; i++)
        above += (level[i] = demi_solid_in(b, g, demi_solid_corner(a, f, a->rim[f] + i))) > 0;
    if (above == (centre > 0 ? n : 0)) return;
    unit = demi_d3_sub(a->face[f].slope, b->face[g].slope);
    if (!(demi_d3_length(unit)*a->face[f].high > 1e-9)) return;         /* the same plane */
    unit = demi_d3_unit(unit);
    count = demi_pyramid_section(a, f, centre, level, x);
    count = demi_pyramid_clip(b, g, x, count);
    if (count > 2)
        demi_pressure_polygon(s, a, f, x, count, unit,
                              demi_d3_dot(demi_d3_sub(b->centre, a->centre), unit));
}
/* True if x is inside. */
static int demi_solid_holds(const demi_solid *s, demi_d3 x) {
    int f;
    for (f = 0; f < s->faces; f++) if (!(demi_solid_in(s, f, x) > 0)) return 0;
    return 1;
}
/* Handles a centre that has passed through a surface. The pressure is undefined there; it is
   replaced by some force along n, and the depth of 2 stops the run. */
static void demi_pressure_beyond(const demi_solid *a, demi_d3 n, demi_pressure *s) {
    const double h = a->face[0].high;
    s->deep = 2;
    if (s->shared > 0 && demi_d3_square(s->force) > 1e-6*s->sum*s->sum) return;
    memset(s, 0, sizeof *s);
    s->deep = 2;
    s->shared = h*h*h;
    s->sum = h*h;
    s->force = demi_d3_scale(n, h*h);
    s->at = demi_d3_scale(a->centre, s->sum);
    s->torque = demi_d3_cross(a->centre, s->force);
}
/* Stretches a prism to 1.5 times its height; its centre is at z = 0. Polygons of a planar world are
   prisms. If two end at the same height, there is a volume in which both u are those of the ends
   and equal, so S, force and energy are undefined. One of the two is therefore stretched
   (demi_prisms_press). */
static void demi_solid_stretch(demi_solid *s) {
    int i;
    for (i = 0; i < s->corners; i++) s->corner[i].z *= 1.5;
    for (i = 0; i < s->faces; i++) {
        s->face[i].slope.z /= 1.5;
        s->face[i].high = 1/demi_d3_length(s->face[i].slope);
    }
}
/* Integrates over all of S. Returns 0 if the two do not overlap. */
static int demi_solids_press(const demi_solid *a, const demi_solid *b, demi_pressure *s) {
    unsigned char fs[DEM_POLYHEDRON_FACES], gs[DEM_POLYHEDRON_FACES];
    int f, g;
    memset(s, 0, sizeof *s);
    memset(fs, 1, sizeof fs);
    memset(gs, 1, sizeof gs);
    if (!demi_solid_alive(a, b, fs, gs) || !demi_solid_alive(b, a, gs, fs)) return 0;
    for (f = 0; f < a->faces; f++)
        for (g = 0; g < b->faces && fs[f]; g++) if (gs[g]) demi_solids_piece(a, b, f, g, s);
    if (demi_solid_holds(b, a->centre) || demi_solid_holds(a, b->centre))
        demi_pressure_beyond(a, demi_d(0, 0, 1), s);
    return s->shared > 0 && s->sum > 0;
}
/* The same for two prisms: the mean of stretching the one and the other, so that it does not depend
   on their order. */
static int demi_prisms_press(const demi_solid *a, const demi_solid *b, demi_pressure *s) {
    demi_solid high = *a;
    demi_pressure other;
    demi_solid_stretch(&high);
    if (!demi_solids_press(&high, b, s)) return 0;
    high = *b;
    demi_solid_stretch(&high);
    if (!demi_solids_press(a, &high, &other)) return 0;
    demi_pressure_add(s, &other);
    demi_pressure_scale(s, 0.5);
    return 1;
}
/* Gauss-Legendre rules with three and four points on 0 .. 1: positions and weights. */
static const double demi_gauss3_at[3] = {0.1127016653792583, 0.5, 0.8872983346207417};
static const double demi_gauss3[3] = {5.0/18, 8.0/18, 5.0/18};
static const double demi_gauss4_at[4] = {0.06943184420297371, 0.33000947820757187,
                                         0.6699905217924281, 0.9305681557970263};
static const double demi_gauss4[4] = {0.17392742256872692, 0.32607257743127307,
                                      0.32607257743127307, 0.17392742256872692};
static int demi_double_order(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}
/* Clips the ray from o in direction (c, sn), from *lo to *hi, to a polygon across z that is
   counter-clockwise (side 1) or clockwise (-1). */
static void demi_polygon_ray(const demi_d3 *x, int count, int side, const double *o, double c,
                             double sn, double *lo, double *hi) {
    int e;
    for (e = 0; e < count; e++) {
        const demi_d3 p = x[e], q = x[e + 1 < count ? e + 1 : 0];
        const double u = side*(p.y - q.y), v = side*(q.x - p.x);
        const double over = u*(o[0] - p.x) + v*(o[1] - p.y), slope = u*c + v*sn;
        if (slope > 0) *lo = DEMI_MAX(*lo, -over/slope);
        else if (slope < 0) *hi = DEMI_MIN(*hi, -over/slope);
        else if (over < 0) *hi = -1;
    }
}
/* Adds the part outside a circular hole (x, y, radius) of a polygon across z in the pyramid of face
   f. It integrates along rays from the hole's centre, in sectors between those to corners and those
   to intersections of sides with the hole's rim. Returns 0, and adds nothing, if the two do not
   overlap. */
static int demi_pressure_round(demi_pressure *s, const demi_solid *a, int f, const demi_d3 *x,
                               int count, demi_d3 unit, double height, const double *hole) {
    double angle[3*DEMI_SECTION + 1], area = 0;
    int i, k, e, piece, angles = 0, left = 0, right = 0, near_by = 0;
    for (i = 0; i < count; i++) {
        const demi_d3 p = x[i], q = x[i + 1 < count ? i + 1 : 0];
        const double u = p.x - hole[0], v = p.y - hole[1], du = q.x - p.x, dv = q.y - p.y;
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
    if (!near_by && left < count && right < count) return 0;    /* nor is its centre inside */
    qsort(angle, (size_t)angles, sizeof *angle, demi_double_order);
    angle[angles] = angle[0] + 2*DEMI_PI;
    for (i = 0; i < angles; i++) {
        const double width = angle[i + 1] - angle[i];
        const int pieces = 1 + (int)(width/0.4);
        for (piece = 0; piece < pieces && width > 1e-15; piece++)
            for (k = 0; k < 4; k++) {
                const double turn = angle[i] + (piece + demi_gauss4_at[k])*width/pieces;
                const double c = demi_cos(turn), sn = demi_sin(turn);
                double lo = hole[2], hi = 1e300;
                demi_polygon_ray(x, count, area > 0 ? 1 : -1, hole, c, sn, &lo, &hi);
                for (e = 0; e < 3 && hi > lo; e++) {
                    const double r = lo + demi_gauss3_at[e]*(hi - lo);
                    const demi_d3 y = demi_d(hole[0] + r*c, hole[1] + r*sn, x[0].z);
                    const double dA = demi_gauss4[k]*width/pieces*demi_gauss3[e]*(hi - lo)*r;
                    demi_pressure_point(s, a, f, y, dA, unit, height);
                }
            }
    }
    return 1;
}
/* True if a side of a flat piece excludes the section of the body with its plane. all: heights of
   the corners above the plane, m. The section is within a ball about the mean of the points at
   which edges cross the plane. */
static int demi_section_outside(const demi_solid *s, const double *all, const demi_half *sides,
                                int side_count) {
    demi_d3 x[3*DEM_POLYHEDRON_FACES], middle = demi_d(0, 0, 0);
    double far2 = 0;
    int f, i, count = 0;
    for (f = 0; f < s->faces; f++)
        for (i = s->rim[f]; i < s->rim[f + 1]; i++) {
            const int32_t a = demi_solid_number(s, f, i), b = demi_solid_number(s, f, i + 1);
            if (a > b || (all[a] > 0) == (all[b] > 0)) continue;
            x[count] = demi_d3_between(s->corner[a], s->corner[b], all[a]/(all[a] - all[b]));
            middle = demi_d3_add(middle, x[count++]);
        }
    middle = demi_d3_over(middle, DEMI_MAX(count, 1));
    for (i = 0; i < count; i++)
        far2 = DEMI_MAX(far2, demi_d3_square(demi_d3_sub(x[i], middle)));
    for (i = 0; i < side_count; i++) {
        const double in = demi_d3_dot(sides[i].n, demi_d3_sub(middle, sides[i].o));
        if (in < 0 && in*in > far2*demi_d3_square(sides[i].n)*(1 + 1e-9)) return 1;
    }
    return 0;
}
/* Adds S on a flat piece of a rigid wall: the part of the plane n.x = at (n unit, into the wall)
   that is within all half spaces `sides`. hole: null, or x, y and radius of a hole in it, across z.
   Without sides, demi_pressure_beyond handles a centre behind the plane. A piece with sides may be
   seen from behind; it then reduces what other pieces contribute. */
static void demi_solid_on_flat(const demi_solid *a, demi_d3 n, double at, const demi_half *sides,
                               int side_count, const double *hole, demi_pressure *s) {
    const double centre = demi_d3_dot(n, a->centre) - at;
    double all[DEMI_HULL_CORNERS], level[DEM_POLYHEDRON_FACES];
    demi_d3 x[DEMI_SECTION];
    int f, i, k, above = 0, count;
    if (centre > 0 && !side_count) { demi_pressure_beyond(a, n, s); return; }
    for (i = 0; i < a->corners; i++) above += (all[i] = demi_d3_dot(n, a->corner[i]) - at) > 0;
    if (above == (centre > 0 ? a->corners : 0) ||
        demi_section_outside(a, all, sides, side_count)) return;
    for (f = 0; f < a->faces; f++) {
        for (i = a->rim[f], k = 0; i < a->rim[f + 1]; i++)
            level[k++] = all[demi_solid_number(a, f, i)];
        count = demi_pyramid_section(a, f, centre, level, x);
        for (i = 0; i < side_count && count > 2; i++)
            count = demi_polygon_clip(x, count, sides[i].n, sides[i].o);
        if (count > 2 && !(hole && demi_pressure_round(s, a, f, x, count, n, -centre, hole)))
            demi_pressure_polygon(s, a, f, x, count, n, -centre);
    }
}

/* --- the contact that follows from a pressure --- */

/* Friction and damping act at four points about the centre of pressure, as far apart as the
   pressure is spread (its second moments), so that a body that lies on a face does not rotate about
   one point. */
typedef struct demi_patch {
    dem_vec3 normal, point;        /* unit, a -> b; m: centre of pressure */
    dem_vec3 spread[2];            /* m: the points are at point +- one +- the other */
    dem_real couple;               /* m: moment about the normal, over the force */
    double force;                  /* m2: integral of u n */
} demi_patch;
/* Returns a unit vector across n: the direction in which the pressure, of second moments M, is
   spread most. Orientations `a` and, of a pair, `b` of the bodies decide where it is spread alike
   in all directions, and its sign. It therefore rotates with the bodies and does not depend on the
   axes of the world, nor on which of two bodies comes first. */
static demi_d3 demi_patch_along(const double *M, demi_d3 n, const dem_quat *a, const dem_quat *b) {
    const demi_d3 t = demi_d3_unit(demi_d3_cross(n, fabs(n.x) < 0.6 ? demi_d(1, 0, 0)
                                                                    : demi_d(0, 1, 0)));
    const demi_d3 e = demi_d3_cross(t, n), Mt = demi_d3_rotate(M, t), Me = demi_d3_rotate(M, e);
    const double hint = 1e-4*(M[0] + M[4] + M[8]);
    double c = demi_d3_dot(e, Me) - demi_d3_dot(t, Mt), s = 2*demi_d3_dot(e, Mt), r;
    demi_d3 way = demi_d(0, 0, 0), along;
    double R[9];
    int k, i;
    for (k = 0; k < (b ? 2 : 1); k++) {
        demi_rotation_of(k ? *b : *a, R);
        way = demi_d3_add(way, demi_d3_rotate(R, demi_d(0.3301, 0.5563, 0.7626)));
        for (i = 1; i < 3; i++) {               /* weights 0, 1 and 2 of the body's axes */
            const demi_d3 axis = demi_d(R[i], R[3 + i], R[6 + i]);
            const double x = demi_d3_dot(e, axis), y = demi_d3_dot(t, axis);
            c += i*hint*(x*x - y*y);
            s += i*hint*2*x*y;
        }
    }
    r = sqrt(c*c + s*s);                        /* (c, s) is at twice the angle */
    along = c > 0 ? demi_d3_plus(demi_d3_scale(e, r + c), s, t)
                  : demi_d3_plus(demi_d3_scale(e, s), r - c, t);
    if (!(demi_d3_length(along) > 0)) return e;
    return demi_d3_scale(demi_d3_unit(along), demi_d3_dot(along, way) < 0 ? -1 : 1);
}
/* Sets the patch of a pressure, from the orientations of both bodies (b: null for a wall). Returns
   0 if it has no force. */
static int demi_pressure_patch(const demi_pressure *s, const dem_quat *a, const dem_quat *b,
                               demi_patch *out) {
    const double *m = s->wide, F = demi_d3_length(s->force), sum2 = s->sum*s->sum;
    demi_d3 n, e, t, Ce, Ct;
    double C[6], M[9], ee, tt, et, root, size;
    int k;
    if (!(F > 0)) return 0;
    n = demi_d3_over(s->force, F);
    out->point = demi_d3_real(demi_d3_plus(demi_d3_over(demi_d3_cross(n, s->torque), F),
                                           demi_d3_dot(n, s->at)/s->sum, n));
    C[0] = s->at.x*s->at.x; C[1] = s->at.y*s->at.y; C[2] = s->at.z*s->at.z;
    C[3] = s->at.x*s->at.y; C[4] = s->at.x*s->at.z; C[5] = s->at.y*s->at.z;
    for (k = 0; k < 6; k++) C[k] = m[k]/s->sum - C[k]/sum2;
    for (k = 0; k < 6; k++) M[3*demi_sym_row[k] + demi_sym_column[k]] = C[k];
    M[3] = C[3]; M[6] = C[4]; M[7] = C[5];
    e = demi_patch_along(M, n, a, b);
    t = demi_d3_cross(n, e);
    Ce = demi_d3_rotate(M, e);
    Ct = demi_d3_rotate(M, t);
    ee = DEMI_MAX(demi_d3_dot(e, Ce), 0);
    tt = DEMI_MAX(demi_d3_dot(t, Ct), 0);
    et = demi_d3_dot(e, Ct);
    root = sqrt(DEMI_MAX(ee*tt - et*et, 0));    /* square root of a 2 x 2 tensor, Cayley-Hamilton */
    size = sqrt(ee + tt + 2*root);
    if (!(size > 0)) size = 1;
    out->normal = demi_d3_real(n);
    out->spread[0] = demi_d3_real(demi_d3_over(demi_d3_plus(demi_d3_scale(e, ee + root), et, t),
                                               size));
    out->spread[1] = demi_d3_real(demi_d3_over(demi_d3_plus(demi_d3_scale(e, et), tt + root, t),
                                               size));
    out->couple = (dem_real)(demi_d3_dot(n, s->torque)/F);
    out->force = F;
    return 1;
}
/* From the centre of pressure to corner k. For the other body, whose normal is opposite, corner k
   is k ^ 1. */
static dem_vec3 demi_patch_spread(const demi_patch *p, int k) {
    const dem_vec3 one = demi_scale(p->spread[0], k & 2 ? DEM_R(-1) : DEM_R(1));
    return demi_add(one, demi_scale(p->spread[1], k & 1 ? DEM_R(-1) : DEM_R(1)));
}
/* Overlap sqrt(I/((4 pi/3)^(1/3) R*)), m; and its derivative with respect to a displacement along a
   force F (of u). */
static double demi_shared_overlap(double shared, double r_eff) {
    return sqrt(shared/(DEMI_POLYHEDRON_SCALE*r_eff));
}
static double demi_shared_slope(double force, double r_eff, double overlap) {
    return force/(2*DEMI_POLYHEDRON_SCALE*r_eff*overlap);
}

/* --- nearest points --- */

/* Finds the point q of a polyhedron nearest to x. Returns its distance, m; if x is inside, q is on
   the nearest face and the distance is negative. */
static double demi_solid_near(const demi_solid *s, demi_d3 x, demi_d3 *q) {
    double inside = -1e300, least = 1e300;
    int f, i;
    for (f = 0; f < s->faces; f++) {
        const demi_d3 a = s->face[f].slope;
        const double size = demi_d3_length(a);
        const double off = (demi_d3_dot(a, demi_d3_sub(x, s->centre)) - 1)/size;
        const demi_d3 n = demi_d3_over(a, size), foot = demi_d3_plus(x, -off, n);
        int beyond = 0;
        if (!(off > 0)) {
            if (off > inside && least > 1e299) {
                inside = off;
                *q = foot;
            }
            continue;
        }
        for (i = s->rim[f]; i < s->rim[f + 1]; i++) {
            const demi_d3 b = demi_solid_corner(s, f, i), to = demi_d3_sub(foot, b);
            const demi_d3 e = demi_d3_sub(demi_solid_corner(s, f, i + 1), b);
            demi_d3 at;
            double t, l;
            if (!(demi_d3_dot(demi_d3_cross(e, n), to) > 0)) continue;
            beyond = 1;
            t = demi_d3_dot(e, to)/demi_d3_square(e);
            at = demi_d3_plus(b, t < 0 ? 0 : t > 1 ? 1 : t, e);
            l = demi_d3_length(demi_d3_sub(x, at));
            if (l < least) { least = l; *q = at; }
        }
        if (!beyond) { *q = foot; return off; }
    }
    return least < 1e299 ? least : inside;
}
/* Sets s to polyhedron p scaled so that the ellipsoid at `at` is the unit sphere about the
   origin. */
static void demi_solid_measure(const demi_part *p, const demi_part *ellipsoid, dem_vec3 at,
                               demi_solid *s) {
    const demi_d3 axes = demi_d3_of(ellipsoid->axes);
    double R[9], back[9];
    int i, k;
    demi_solid_of(p, at, s);
    demi_rotation_of(ellipsoid->q, R);
    for (i = 0; i < 9; i++) back[i] = R[i%3*3 + i/3];
    for (i = -1; i < s->corners; i++) {
        demi_d3 *x = i < 0 ? &s->centre : &s->corner[i];
        *x = demi_d3_rotate(back, *x);
        *x = demi_d(x->x/axes.x, x->y/axes.y, x->z/axes.z);
    }
    for (k = 0; k < 3; k++) { back[k] *= axes.x; back[3 + k] *= axes.y; back[6 + k] *= axes.z; }
    for (i = 0; i < s->faces; i++) s->face[i].slope = demi_d3_rotate(back, s->face[i].slope);
}
/* True if the face of p that most faces q's centre separates p from q. This rejects most pairs that
   are apart, from one side or the other. */
static int demi_face_keeps(const demi_part *p, const demi_part *q, dem_vec3 gap) {
    const demi_d3 own = demi_d3_of(dem_quat_unrotate(p->q, gap));
    const double scale = (double)p->scale, *a = p->shape->hull;
    double most = -1e300;
    dem_vec3 n;
    int f, face = 0;
    for (f = 0; f < p->shape->faces; f++, a += 4) {
        const double off = demi_d3_dot(demi_d3_at(a), own)*a[3] - scale*a[3];
        if (off > most) { most = off; face = f; }
    }
    n = dem_quat_rotate(p->q, demi_face_normal(p->shape, face));
    return (dem_real)most > demi_part_support(q, demi_scale(n, -1))*
        (1 + 16*(DEMI_SINGLE ? DEM_R(1e-7) : DEM_R(2e-16)));
}
