/* ---------------------------------------------------------------------------------------------
   >>on-walls
   Contact points of parts of bodies with walls: geometry only. First spheres (and clusters, which
   are many spheres), then ellipsoids, which share the code for surfaces of facets; finally how the
   normals rotate there as a sphere moves. >>persistent makes contacts of the contact points.
   --------------------------------------------------------------------------------------------- */

/* m: candidates with gaps up to this, as of when the list was built, may touch now or be within the
   range of the law. Any grain and any wall may have moved that far towards each other since. */
DEM_INLINE dem_real demi_walls_gone(const dem_world *w) {
    return (dem_real)(w->margin.gone + w->margin.walls_gone + w->margin.reach);
}
/* True if a body was just set and is not half a step ahead with the walls (demi_move_midpoint). */
DEM_INLINE int demi_walls_late(const dem_world *w, int body) {
    return demi_response_is(w, DEMI_MIDWAY) && !w->bodies.went[body];
}
/* True if there is such a body among those of domain d. */
DEM_INLINE int demi_some_late(const dem_world *w, int d) {
    const demi_domain *o = &w->domains[d];
    return demi_response_is(w, DEMI_MIDWAY) && o->end > o->begin &&
        memchr(w->bodies.went + o->begin, 0, (size_t)(o->end - o->begin));
}
/* Displacement, m, of what is at `at` if it moves half a step ahead with a surface. */
static DEMI_APART dem_vec3 demi_wall_carry(const dem_world *w, const demi_wall *wall, dem_vec3 at) {
    const demi_wall *whole = wall->scale || wall->whose ? &w->walls[wall->lead] : wall;
    const dem_vec3 x = demi_unrotate(whole->mid.rotation, demi_sub(at, whole->mid.position));
    return demi_add(demi_sub(whole->pose.position, whole->mid.position), demi_sub(
        demi_rotate(whole->pose.rotation, x), demi_rotate(whole->mid.rotation, x)));
}
/* The candidates of one body on one wall. In a periodic world several images of the body may be
   near the wall, and of a tessellation several cells; demi_view_next steps through them in list
   order. */
typedef struct demi_view {
    const dem_world *w;
    const demi_wall *wall;
    int d;                         /* work group */
    dem_real gone;                 /* m: candidates with larger gaps are skipped */
    dem_vec3 at;                   /* m, centre of the part of the body, in world axes */
    const int32_t *element;        /* of the candidates of this image; `count` of them */
    const dem_real *gap, *from;    /* m: their gaps; their shifts, x 3 */
    const int32_t *cell;           /* their cells, of a tessellation that repeats */
    int count, left;               /* left: count, plus those of later images */
    int32_t base;                  /* added to the numbers of elements: tells cells apart */
    int several; /* 1: other surfaces are near the body, see demi_persistent_cover */
    int late;                      /* 1: the body was just set, and moves along with the wall */
    dem_vec3 shift, x;             /* m: from body to image; the part in the frame of the wall */
} demi_view;
/* Returns the view of candidates first .. last - 1 of work group d, before its first image. The
   caller sets `at`. */
DEM_INLINE demi_view demi_view_of(const dem_world *w, int d, int first, int last) {
    const int k = d*w->wall_stride + first;
    demi_view v;
    v.w = w;
    v.wall = demi_surface_of(w, w->wall_id[k]);
    v.d = d;
    v.gone = demi_walls_gone(w);
    v.element = w->wall_element + k;
    v.gap = w->wall_gap + k;
    v.from = w->wall_shift + 3*(size_t)k;
    v.cell = w->wall_cell + k;
    v.base = 0;
    v.count = v.several = v.late = 0;
    v.left = last - first;
    return v;
}
/* Advances to the next image; 0: there is none. */
DEM_INLINE int demi_view_next(demi_view *v) {
    v->element += v->count;
    v->gap += v->count;
    v->from += 3*v->count;
    v->cell += v->count;
    v->left -= v->count;
    v->count = v->left;
    if (!v->left) return 0;
    if (v->w->repeating || v->wall->step[0].x > 0)
        for (v->count = 1; v->count < v->left && v->cell[0] == v->cell[v->count] &&
             !memcmp(v->from, v->from + 3*v->count, 3*sizeof *v->from); v->count++) continue;
    v->shift = demi_at(v->from);
    if (v->late)
        v->shift = demi_add(v->shift, demi_wall_carry(v->w, v->wall, demi_add(v->at, v->shift)));
    v->x = demi_unrotate(v->wall->pose.rotation,
                         demi_sub(demi_add(v->at, v->shift), v->wall->pose.position));
    if (v->wall->step[0].x > 0) {
        v->base = (int32_t)((uint32_t)*v->cell%(uint32_t)(INT32_MAX/v->wall->number_count))*
            v->wall->number_count;
        v->x = demi_sub(v->x, demi_cell_shift(v->wall, *v->cell, v->x));
    }
    return 1;
}
/* Prepares the room `at` for the contact points of one body and one wall. */
DEM_INLINE demi_places demi_places_begin(const demi_view *v, demi_touching *at) {
    demi_places p;
    memset(&p, 0, sizeof p);
    p.at = at;
    if (v->left > 10) {
        uint32_t size = 64;
        while (size < 2*7*(uint32_t)v->left) size *= 2;
        p.table = v->w->touching_table + 4*v->w->domains[v->d].touching_first;
        p.mask = size - 1;
        memset(p.table, 0, size*sizeof *p.table);
    }
    return p;
}
/* True if candidate k, a facet, may be nearer than `within`: its gap may have closed, and its plane
   is near enough. */
DEM_INLINE int demi_facet_near(const demi_view *v, int k, dem_real within) {
    const dem_real *plane = DEMI_AT(v->wall->planes, v->element[k]);
    const dem_real off = plane[0]*v->x.x + plane[1]*v->x.y + plane[2]*v->x.z - plane[3];
    return !(v->gap[k] > v->gone) && !(DEMI_ABS(off) > within*DEM_R(1.001) + v->wall->plane_slack);
}
/* Corrects the contact points for open rings (>>touch): those of the image at which the view is or,
   where the surface continues in others, of all images; `start` is before these. */
static void demi_view_rings(const demi_view *start, const demi_part *part, dem_real within,
                            dem_real near_by, demi_places *p) {
    const int numbers = start->wall->number_count, all = start->wall->wraps, offset = p->offset;
    demi_view v = *start;
    demi_touching *t;
    demi_ring ring;
    int q;
    memset(&ring, 0, sizeof ring);
    ring.link = v.w->touching_links + v.w->domains[v.d].touching_first;
    for (ring.offset = all ? 0 : offset; all ? demi_view_next(&v) : ring.offset == offset;
         ring.offset += numbers)
        for (q = 0; q < v.count; q++)
            demi_links_add(v.wall, v.element[q], v.x, part, within, &ring);
    if (all) demi_links_share(&ring, numbers, near_by);
    demi_places_rings(&ring, within, demi_normal_is(v.w, DEMI_HERTZIAN) ? DEM_R(2.5) : DEM_R(2), p);
    p->offset = offset;
    for (v = *start, ring.offset = 0; all && demi_view_next(&v); ring.offset += numbers)
        for (t = p->at; t < p->at + p->count; t++)
            if (t->element/numbers == ring.offset/numbers) { t->shift = v.shift; t->base = v.base; }
}
/* Finds the contact points of a sphere of radius r, or of an ellipsoid (`part` not null), with a
   surface of facets, in world axes. Overlaps are r minus the distance, or 1 - W0. Points within
   `range` (m) are included, with negative overlaps. Returns their number. */
static int demi_facets_touch(const demi_view *start, dem_real r, const demi_part *part,
                             dem_real range, demi_touching *out) {
    demi_view v = *start;
    const demi_wall *wall = v.wall;
    const dem_real *R = wall->pose.rotation;
    const dem_real touch = part ? DEM_R(1) : r;
    const dem_real within = touch + (part ? range/demi_part_thin(part) : range);
    const dem_real near_by = within*(DEMI_SINGLE ? DEM_R(2e-5) : DEM_R(1e-9));
    demi_places p = demi_places_begin(start, out);
    const int numbers = wall->number_count;
    int k, q, from, one, reached, ringed = 0;   /* ringed: a weight is negative */
    for (; demi_view_next(&v); p.offset += numbers) {
        from = p.count;
        for (q = 0, one = v.count, reached = 0; q < v.count && !part; q++) {
            if (!demi_facet_near(&v, q, within)) continue;
            if (!reached++) one = q;
        }
        if (reached == 1 && wall->lone) {
            demi_facet_alone(wall, v.element[one], v.x, within, &p);
            if (p.count > from) { p.at[from].shift = v.shift; p.at[from].base = v.base; }
            continue;
        }
        for (q = one; q < v.count; q++)         /* spheres have specialised code */
            if (demi_facet_near(&v, q, within))
                demi_facet_places(wall, v.element[q], v.x, 0, within, &p);
        for (q = 0; q < v.count && part; q++)
            if (!(v.gap[q] > v.gone))
                demi_facet_places(wall, v.element[q], v.x, part, within, &p);
        for (q = from, ringed = ringed && wall->wraps; q < p.count; q++)
            ringed |= p.at[q].share < DEM_R(-1e-3);
        if (ringed && !wall->wraps) demi_view_rings(&v, part, within, near_by, &p);
        for (q = from; q < p.count; q++) { p.at[q].shift = v.shift; p.at[q].base = v.base; }
    }
    if (ringed && wall->wraps) demi_view_rings(start, part, within, near_by, &p);
    if (p.count > 1 || (p.count && p.at->share < 1)) demi_places_merge(&p, near_by);
    for (k = 0; k < p.count; k++) {
        demi_touching *t = p.at + k;
        dem_vec3 to = t->point, n = t->point;
        t->element = t->element%numbers + t->base;
        if (part) {
            const dem_vec3 a = part->axes;
            to = dem_quat_rotate(part->q, demi_v(n.x*a.x, n.y*a.y, n.z*a.z));
            n = dem_quat_rotate(part->q, demi_v(n.x/a.x, n.y/a.y, n.z/a.z));
        }
        n = t->overlap > 0 ? demi_scale(n, 1/demi_length(n)) : demi_v(0, 0, -1);
        t->overlap = touch - t->overlap;
        t->normal = demi_rotate(R, n);
        t->point = demi_add(v.at, demi_rotate(R, to));
    }
    return p.count;
}
/* --- contact points of one part of a body with one wall. `v` is before its first image. Each
   function writes normals, points, overlaps (for an ellipsoid 1 - W0) and weights, in world axes,
   to `out`, the room of its work group, and returns their number. --- */
typedef int (*demi_touch_fn)(const demi_view *v, const demi_part *part, demi_touching *out);
static int demi_facets_spheres(const demi_view *v, const demi_part *part, demi_touching *out) {
    return demi_facets_touch(v, part->radius, 0, demi_range(v->w, part->radius), out);
}
/* Finds the contact points of a sphere with a surface of revolution. A piece (a cone between two
   meridian points) counts if the nearest point is between its ends. An edge circle ("ring") counts
   if the sphere is beyond the ends of all pieces at it. A ring between two pieces that both count
   has negative weight, as where rows of a sieve cross: the second contact then begins without a
   jump in an inner corner, however deep the sphere is in the first. Elements: pieces, then
   rings. */
static int demi_revolved_touch(const demi_wall *wall, dem_vec3 x, dem_real r, demi_touching *out) {
    const dem_real l = DEMI_SQRT(x.x*x.x + x.y*x.y);
    const dem_vec3 d = l > 0 ? demi_v(x.x/l, x.y/l, 0) : demi_v(1, 0, 0);
    const int pieces = wall->ring_count - 1;
    int k, end, part, before = 1, count = 0;    /* before: did the last piece end here? */
    for (k = 0; k <= pieces; k++) {
        dem_real a = wall->ring_radius[k], b = wall->ring_height[k], dist = 0;
        int how;                                /* sign of the weight; 0: does not count */
        end = -1;
        if (k < pieces) dist = demi_ring_piece(wall, k, l, x.z, &a, &b, &end);
        for (part = 0; part < 2; part++) {      /* the piece, then the ring where it begins */
            how = part ? (before > 0 && end < 0) - (k && !before && !end) : k < pieces && !end;
            if (!how) continue;
            if (part) {
                a = wall->ring_radius[k];
                b = wall->ring_height[k];
                dist = DEMI_SQRT((l - a)*(l - a) + (x.z - b)*(x.z - b));
            }
            if (!(r - dist > 0)) continue;
            out[count].element = part ? pieces + k : k;
            out[count].share = wall->share*(dem_real)how;
            out[count].overlap = r - dist;
            out[count].point = demi_v(d.x*a, d.y*a, b);
            out[count].normal = dist > 0 ? demi_scale(demi_sub(out[count].point, x), 1/dist) : d;
            count++;
        }
        before = end;
    }
    return count;
}
/* Finds the contact points of a sphere with a wall; each element gives at most one. A law's range
   is added to the radius and taken off the overlaps. how: 0 by `near`; 1 segments, which exert a
   fraction of the force; 2 a sieve and 3 a surface of revolution: one candidate with several
   contacts. */
DEM_INLINE int demi_spheres_touch(const demi_view *start, dem_real radius, demi_touching *out,
                                  int how, demi_near_fn near) {
    demi_view v = *start;
    const demi_wall *wall = v.wall;
    const dem_real *R = wall->pose.rotation, range = demi_range(v.w, radius), r = radius + range;
    int k, q, count = 0;
    while (demi_view_next(&v)) {
        const int from = count;
        if (how == 2) count += demi_sieve_touch(&wall->sieve, v.x, r, range, out + count);
        else if (how == 3) count += demi_revolved_touch(wall, v.x, r, out + count);
        else for (k = 0; k < v.count; k++) {
            demi_touching *c = &out[count];
            if (v.gap[k] > v.gone) continue;
            c->element = v.element[k];
            c->share = wall->share;
            if (how == 1) {
                c->share = demi_segment_share(wall, c->element, v.x, r, &c->normal, &c->point,
                                              &c->overlap);
                if (!(c->share > 0)) continue;
            } else {
                c->overlap = near(wall, c->element, v.x, r, &c->normal, &c->point);
                if (!(c->overlap > 0)) continue;
            }
            count++;
        }
        for (q = from; q < count; q++) {
            out[q].overlap -= range;
            out[q].normal = demi_rotate(R, out[q].normal);
            out[q].point = demi_sub(demi_add(wall->pose.position, demi_rotate(R, out[q].point)),
                                    v.shift);
            out[q].shift = v.shift;
        }
    }
    return count;
}
static int demi_plane_spheres(const demi_view *v, const demi_part *part, demi_touching *out) {
    return demi_spheres_touch(v, part->radius, out, 0, demi_plane_near);
}
static int demi_cylinder_spheres(const demi_view *v, const demi_part *part, demi_touching *out) {
    return demi_spheres_touch(v, part->radius, out, 0, demi_cylinder_near);
}
/* Any other wall of elements. */
static int demi_elements_touch(const demi_view *v, const demi_part *part, demi_touching *out) {
    return demi_spheres_touch(v, part->radius, out, 0, demi_nears[v->wall->kind]);
}
static int demi_segments_touch(const demi_view *v, const demi_part *part, demi_touching *out) {
    return demi_spheres_touch(v, part->radius, out, 1, 0);
}
static int demi_revolved_spheres(const demi_view *v, const demi_part *part, demi_touching *out) {
    return demi_spheres_touch(v, part->radius, out, 3, 0);
}
static int demi_sieve_spheres(const demi_view *v, const demi_part *part, demi_touching *out) {
    return demi_spheres_touch(v, part->radius, out, 2, 0);
}

/* --- an ellipsoid and a wall element, in the frame of the wall; Q: its matrix there --- */

/* Returns a maximum, near a start angle, of n.x + h (out = 1: distance from the origin of the
   farthest point) or of n.x - h (out = -1: that of the nearest), where h = sqrt(n.Q n) and n =
   (cos, sin), for the ellipse of Q's first two rows about x. n receives the direction. Newton's
   method, with steps uphill where the curvature is positive. */
static double demi_ellipse_far(demi_sym Q, double x, double y, int out, double angle, double *n) {
    int k;
    for (k = 0;; k++) {
        const double c = demi_cos(angle), s = demi_sin(angle);
        const double qn0 = Q.xx*c + Q.xy*s, qn1 = Q.xy*c + Q.yy*s;
        const double h = sqrt(c*qn0 + s*qn1), cross = -s*qn0 + c*qn1;
        const double best = c*x + s*y + out*h, size = fabs(x) + fabs(y) + h;
        const double slope = -s*x + c*y + out*cross/h;
        const double bend = -(c*x + s*y) + out*((Q.xx + Q.yy)/h - 2*h - cross*cross/(h*h*h));
        const int still = fabs(slope) < 1e-14*size;
        double step;
        n[0] = c;
        n[1] = s;
        if (k == 60 || (still && bend < 1e-9*size)) return best;
        /* positive curvature: away from the minimum, never more than half a radian */
        step = still ? 0.01 : bend < 0 ? -slope/bend : slope > 0 ? 0.3 : -0.3;
        angle += step > 0.5 ? 0.5 : step < -0.5 ? -0.5 : step;
    }
}
/* Returns the support height of an ellipsoid in direction n, m. *arm: from its centre to the
   surface point there, Q n/h. */
static dem_real demi_ellipsoid_arm(const demi_part *p, dem_vec3 n, dem_vec3 *arm) {
    const dem_vec3 e = dem_quat_unrotate(p->q, n), a = p->axes;
    const dem_vec3 s = demi_v(a.x*e.x, a.y*e.y, a.z*e.z);
    const dem_real h = demi_length(s);
    *arm = demi_scale(dem_quat_rotate(p->q, demi_v(a.x*s.x, a.y*s.y, a.z*s.z)), 1/h);
    return h;
}
/* Half its width along n, in the plane across the axis, m. */
static double demi_ellipse_height(demi_sym Q, const double *n) {
    return sqrt(n[0]*n[0]*Q.xx + 2*n[0]*n[1]*Q.xy + n[1]*n[1]*Q.yy);
}
/* Returns 1 - W0, where W0 is the scale at which an ellipsoid about x just touches a cylinder of
   radius R (out = 1: from inside; -1: from outside). n: the direction of the contact point across
   the axis. Newton's method on W, starting at W = 1 with `far` and n; the distance of the far end
   changes with W at the rate of the support height. If the centre has reached the wall, the result
   is that of the wall point next to it: W0 then decreases below 0 behind the wall, so that
   penetration is detected. */
static double demi_ellipse_shrink(demi_sym Q, double x, double y, int out, double R,
                                  double far, double *n) {
    const double from_axis = sqrt(x*x + y*y);
    double W = 1;
    int k;
    for (k = 0; k < 20; k++) {
        const double step = out*(R - far)/demi_ellipse_height(Q, n);
        demi_sym S = Q;
        W += step;
        if (!(W > 1e-3) && from_axis > 0) {
            n[0] = x/from_axis;
            n[1] = y/from_axis;
            return 1 - out*(R - from_axis)/demi_ellipse_height(Q, n);
        }
        S.xx *= W*W; S.xy *= W*W; S.yy *= W*W;
        far = demi_ellipse_far(S, x, y, out, demi_atan2(n[1], n[0]), n);
        if (fabs(step) < 1e-15) break;
    }
    return 1 - W;
}
/* --- one ellipsoid, rotated into the frame of the wall, against one element, with its centre at x.
   Each function sets normal and point and returns 1 - W0, which is 0 or less if the two are apart.
   If they are farther apart than `range` (m), it may return any smaller value. --- */
typedef dem_real (*demi_ellipsoid_fn)(const demi_wall *wall, int element, const demi_part *p,
                                      dem_vec3 x, dem_real range, dem_vec3 *normal,
                                      dem_vec3 *point);
/* Returned if the gap exceeds any range. */
#define DEMI_FAR_OFF DEM_R(-1e30)
/* At its lowest point. W0 is the height of its centre over its support height. */
static dem_real demi_ellipsoid_on_plane(const demi_wall *wall, int element, const demi_part *p,
                                        dem_vec3 x, dem_real range, dem_vec3 *normal,
                                        dem_vec3 *point) {
    dem_vec3 arm;
    dem_real h;
    (void)wall; (void)element; (void)range;
    *normal = demi_v(0, 0, -1);
    h = demi_ellipsoid_arm(p, *normal, &arm);
    *point = demi_v(x.x + arm.x*x.z/h, x.y + arm.y*x.z/h, 0);
    return 1 - x.z/h;
}
/* Inside a cylinder both ends of a long body may touch: elements 0 and 1. */
static dem_real demi_ellipsoid_on_cylinder(const demi_wall *wall, int element, const demi_part *p,
                                           dem_vec3 x, dem_real range, dem_vec3 *normal,
                                           dem_vec3 *point) {
    const demi_sym Q = demi_ellipsoid_matrix(p->q, p->axes);
    double n[3], far, left;
    dem_vec3 arm;
    far = demi_ellipse_far(Q, (double)x.x, (double)x.y, wall->inside ? 1 : -1, wall->inside
                             ? demi_atan2(2*Q.xy, Q.xx - Q.yy)/2 + (element ? DEMI_PI : 0)
                             : demi_atan2((double)x.y, (double)x.x), n);
    left = far - (double)wall->radius;
    if (!(wall->inside ? left > -(double)range : left < (double)range)) return DEMI_FAR_OFF;
    left = demi_ellipse_shrink(Q, (double)x.x, (double)x.y, wall->inside ? 1 : -1,
                               (double)wall->radius, far, n);
    *normal = demi_v((dem_real)n[0], (dem_real)n[1], 0);
    if (!wall->inside) *normal = demi_scale(*normal, -1);
    demi_ellipsoid_arm(p, *normal, &arm);
    *point = demi_v((dem_real)n[0]*wall->radius, (dem_real)n[1]*wall->radius,
                    x.z + arm.z*(dem_real)(1 - left));
    return (dem_real)left;
}
/* A grain of the wall (element), by the contact point of Perram and Wertheim. Returns DEMI_FAR_OFF
   if the gap exceeds `range`, m. */
static dem_real demi_ellipsoid_on_grain(const demi_wall *wall, int element, const demi_part *p,
                                        dem_vec3 x, dem_real range, dem_vec3 *normal,
                                        dem_vec3 *point) {
    const dem_vec3 gap = demi_sub(demi_at(wall->vertices + 3*element), x);
    const double most = 1 + (double)range/(double)(demi_part_thin(p) + wall->radius);
    const dem_vec3 round = demi_v(wall->radius, wall->radius, wall->radius);
    const demi_sym A = demi_ellipsoid_matrix(p->q, p->axes);
    const demi_sym B = demi_ellipsoid_matrix(dem_quat_make(1, 0, 0, 0), round);
    demi_d3 r = demi_d3_of(gap), n;
    double ha, hb;
    demi_meet m;
    if (!(demi_d3_square(r) > 0)) r.z = 1e-9*(double)demi_part_thin(p);
    m.l = demi_meet_start(demi_sym_height(A, r), demi_sym_height(B, r));
    demi_meet_solve(A, B, r, most*most, DEMI_MEET_NEAR, &m);
    if (!(m.f < most*most)) return DEMI_FAR_OFF;
    demi_meet_heights(&m, &n, &ha, &hb);
    *normal = demi_d3_real(n);
    *point = demi_add(x, demi_d3_real(demi_d3_scale(m.a, 1 - m.l)));
    return (dem_real)(1 - sqrt(m.f));
}
/* A part as seen in a frame of axes R, such as that of a wall or a wire. */
static demi_part demi_part_local(const dem_real *R, const demi_part *p) {
    demi_part local = *p;
    double turn[3][3];
    int i, e;
    for (i = 0; i < 3; i++) for (e = 0; e < 3; e++) turn[i][e] = (double)R[3*e + i];
    local.q = demi_quat_unit(dem_quat_multiply(demi_quat_of(turn), p->q));
    return local;
}
static int demi_facets_ellipsoid(const demi_view *v, const demi_part *part, demi_touching *out) {
    const demi_part local = demi_part_local(v->wall->pose.rotation, part);
    return demi_facets_touch(v, 0, &local, demi_range(v->w, part->radius), out);
}
/* Contact points of an ellipsoid with a wall, element by element. */
static int demi_ellipsoid_touch(const demi_view *start, const demi_part *part, demi_touching *out,
                                demi_ellipsoid_fn on) {
    demi_view v = *start;
    const demi_wall *wall = v.wall;
    const dem_real *R = wall->pose.rotation;
    const demi_part local = demi_part_local(wall->pose.rotation, part);
    const dem_real range = demi_range(v.w, part->radius);
    const int two = wall->inside;
    int i, count = 0;
    while (demi_view_next(&v))
        for (i = 0; i < v.count + two; i++) {
            demi_touching *c = &out[count];
            if (v.gap[DEMI_MIN(i, v.count - 1)] > v.gone) continue;
            c->element = i < v.count ? v.element[i] : 1;
            c->overlap = on(wall, c->element, &local, v.x, range, &c->normal, &c->point);
            if (!(c->overlap > 0) && !(c->overlap > -range/demi_part_thin(&local))) continue;
            c->normal = demi_rotate(R, c->normal);
            if (two && count && demi_dot(c->normal, out->normal) > DEM_R(0.99)) continue;
            c->point = demi_sub(demi_add(wall->pose.position, demi_rotate(R, c->point)), v.shift);
            c->shift = v.shift;
            c->share = wall->share;
            count++;
        }
    return count;
}
static int demi_plane_ellipsoid(const demi_view *v, const demi_part *part, demi_touching *out) {
    return demi_ellipsoid_touch(v, part, out, demi_ellipsoid_on_plane);
}
static int demi_cylinder_ellipsoid(const demi_view *v, const demi_part *part, demi_touching *out) {
    return demi_ellipsoid_touch(v, part, out, demi_ellipsoid_on_cylinder);
}
static int demi_grain_ellipsoid(const demi_view *v, const demi_part *part, demi_touching *out) {
    return demi_ellipsoid_touch(v, part, out, demi_ellipsoid_on_grain);
}

/* --- rotation of the normal of a sphere's contact with a wall as the sphere moves, in the frame of
   the wall. The normal rotates by `turn` times the displacement of the sphere, except for
   components along the normal and along `axis`, if it is not 0; for the latter the rate is `along`.
   among: the elements in which this contact was found. --- */
typedef struct demi_bend {
    int number;
    dem_real dist;                 /* m, > 0: from the sphere's centre to the surface */
    dem_vec3 normal, point;        /* unit, towards the wall; m, nearest point of the surface */
    dem_real turn, along;          /* 1/m; initially 0 */
    dem_vec3 axis;                 /* unit, or 0: none; initially 0 */
} demi_bend;
typedef void (*demi_bend_fn)(const demi_wall *wall, const int32_t *among, int count, demi_bend *b);
static void demi_cylinder_bend(const demi_wall *wall, const int32_t *among, int count,
                               demi_bend *b) {
    const dem_real out = wall->inside ? b->dist - wall->radius : b->dist + wall->radius;
    (void)among; (void)count;
    b->axis.z = 1;
    b->turn = out < 0 || out > 0 ? -1/out : 0;
}
/* Pieces and rings rotate the normal about the axis of revolution, as far as it points outwards.
   Rings also rotate it along the meridian, as corners do. */
static void demi_revolved_bend(const demi_wall *wall, const int32_t *among, int count,
                               demi_bend *b) {
    const dem_vec3 x = demi_sub(b->point, demi_scale(b->normal, b->dist));
    const dem_real l = DEMI_SQRT(x.x*x.x + x.y*x.y);
    const dem_vec3 d = l > 0 ? demi_v(x.x/l, x.y/l, 0) : demi_v(1, 0, 0);
    const dem_real out = demi_dot(b->normal, d);
    (void)among; (void)count;
    b->axis = demi_unit(demi_v(-b->normal.z*d.x, -b->normal.z*d.y, out));
    b->along = b->number < wall->ring_count - 1 ? 0 : -1/b->dist;
    b->turn = l > 0 ? out/l : 0;
}
/* Grains of a wall, and anything else round about a point. */
static void demi_grain_bend(const demi_wall *wall, const int32_t *among, int count, demi_bend *b) {
    demi_cylinder_bend(wall, among, count, b);
    b->axis.z = 0;
}
/* Lines do not rotate the normal. Corners do, about the direction of extrusion of the profile. */
static void demi_profile_bend(const demi_wall *wall, const int32_t *among, int count,
                              demi_bend *b) {
    (void)among; (void)count;
    b->axis.z = 1;
    b->turn = b->number < wall->element_count ? 0 : -1/b->dist;
}
/* Faces do not rotate the normal. An edge rotates it about itself, a corner in all directions. */
static void demi_mesh_bend(const demi_wall *wall, const int32_t *among, int count, demi_bend *b) {
    const int edges = wall->element_count, corners = edges + wall->edge_count, number = b->number;
    int k, q, found = 0;
    if (number < edges) return;
    b->turn = -1/b->dist;
    for (k = 0; k < count && !found && number < corners; k++) {
        const int e = among[k];
        dem_vec3 y[3];
        demi_wall_corners(wall, e, y);
        for (q = 0; q < 3 && !found; q++)
            if ((found = edges + wall->edges[3*e + q] == number) != 0)
                b->axis = demi_unit(demi_sub(y[(q + 1)%3], y[q]));
    }
}
/* At a curve the normal n rotates by -1/dist for displacements across it. Along it, with K the
   second derivative of the curve by its arc length, the nearest point moves 1/(1 + dist n.K) times
   the displacement, so n rotates by -n.K/(1 + dist n.K). That is negative where the point is the
   farthest one. tangent: unit; nK = n.K, 1/m. */
static void demi_curve_bend(demi_bend *b, dem_vec3 tangent, dem_real nK) {
    const dem_real left = 1 + b->dist*nK;
    b->turn = -1/b->dist;
    b->axis = tangent;
    b->along = -nK/(left < 0 ? DEMI_MIN(left, DEM_R(-0.1)) : DEMI_MAX(left, DEM_R(0.1)));
}
/* At the rim of radius R about (0, 0) with nearest point `at`. On the upright side of a plate the
   normal rotates only about the axis of the rim. */
static void demi_rim_bend(demi_bend *b, dem_real R, dem_vec3 at, int upright) {
    const dem_real nK = -(b->normal.x*at.x + b->normal.y*at.y)/(R*R);
    demi_curve_bend(b, demi_v(-at.y/R, at.x/R, 0), nK);
    if (upright) b->turn = 0;
}
/* At the edge where the surfaces X^2 + (Z - h)^2 = q^2 and Y^2 + (Z + h)^2 = q^2 of two wires
   intersect. Its tangent t is the cross product of their gradients g and f, and along it
       K.g = t_y^2 - 1,   K.f = t_x^2 - 1 */
static void demi_wires_bend(demi_bend *b, const dem_sieve_desc *s) {
    const dem_real pitch = s->aperture + s->bar, h = s->lift/2, q2 = s->bar*s->bar/4;
    const dem_vec3 p = b->point;
    const dem_real X = p.x - ((dem_real)floor((double)(p.x/pitch)) + DEM_R(0.5))*pitch;
    const dem_real Y = p.y - ((dem_real)floor((double)(p.y/pitch)) + DEM_R(0.5))*pitch;
    const dem_vec3 g = demi_v(X, 0, p.z - h), f = demi_v(0, Y, p.z + h);
    const dem_real gf = demi_dot(g, f), det = q2*q2 - gf*gf;
    const dem_real ng = demi_dot(b->normal, g), nf = demi_dot(b->normal, f);
    b->turn = -1/b->dist;
    if (det > DEM_R(1e-6)*q2*q2) {         /* det n = (ng q2 - nf gf) g + (nf q2 - ng gf) f */
        const dem_vec3 t = demi_unit(demi_cross(g, f));
        const dem_real Kg = t.y*t.y - 1, Kf = t.x*t.x - 1;
        demi_curve_bend(b, t, ((ng*q2 - nf*gf)*Kg + (nf*q2 - ng*gf)*Kf)/det);
    }
}
/* Wires rotate the normal about themselves and flat rows not at all; ends of wires and corners of
   plates in all directions; upright corners about themselves. */
static void demi_sieve_bend(const demi_wall *wall, const int32_t *among, int count, demi_bend *b) {
    const dem_sieve_desc *s = &wall->sieve;
    const dem_vec3 n = b->normal, p = b->point;
    const dem_real R = s->radius, hair = DEMI_SINGLE ? DEM_R(1e-5) : DEM_R(1e-10);
    const int wires = demi_sieve_wires(s);
    const int upright = !wires && s->thickness > 0 && DEMI_ABS(n.z) < hair;
    const int corner = b->number == DEMI_SIEVE_RIM + 1;      /* of a strip, or on the rim between */
    const int cross = b->number < DEMI_SIEVE_FACE && (b->number & DEMI_SIEVE_CROSS);
    const int ring = b->number == DEMI_SIEVE_RIM ||
        (corner && DEMI_ABS(n.x*p.y - n.y*p.x) < R*DEM_R(1e-5));
    const dem_real edge = wires && !cross ? s->bar/2 : DEM_R(0);
    const dem_vec3 foot = demi_add(p, demi_scale(n, edge));
    const int end = R > 0 && !(foot.x*foot.x + foot.y*foot.y < R*R*DEM_R(0.999999));
    (void)among; (void)count;
    if (b->number == DEMI_SIEVE_FACE) return;
    if (!ring && s->kind == DEM_SIEVE_ROUND) {         /* the hole's centre is opposite to n */
        const dem_real l = DEMI_SQRT(n.x*n.x + n.y*n.y), a = s->aperture/2;
        if (l > 0) demi_rim_bend(b, a, demi_v(n.x*a/l, n.y*a/l, 0), upright);
    } else if (wires && cross) demi_wires_bend(b, s);
    else if (ring || (end && !wires && !corner && !cross)) demi_rim_bend(b, R, foot, upright);
    else {
        const int row = !end && !corner && !cross;
        if (row && (upright || (b->number & DEMI_SIEVE_ABOVE))) return;
        b->turn = -1/(b->dist + edge);
        if (row) b->axis = b->number & DEMI_SIEVE_SET ? demi_v(1, 0, 0) : demi_v(0, 1, 0);
        else if (upright) b->axis = demi_v(0, 0, 1);
    }
}
#define DEMI_WALL_BEND(KIND, C, M, T, N, NEAR, TOUCH, BEND, TESS) BEND,
static const demi_bend_fn demi_bends[] = {0, DEMI_WALLS(DEMI_WALL_BEND)};
/* Returns what only few contacts need, for a contact that needs it from now on. */
DEM_INLINE demi_persistent_more *demi_persistent_odd(demi_persistent *c) {
    if (c->odd) return &c->more;
    c->odd = 1;
    memset(&c->more, 0, sizeof c->more);
    return &c->more;
}
/* Sets bend, along and axis for a sphere's contact. dist: m, from its centre to the surface;
   point: of the wall's surface, for the image of the body that touches it. */
static void demi_wall_bend(const demi_wall *wall, const int32_t *among, int count, dem_real dist,
                           dem_vec3 point, demi_persistent *c) {
    const dem_real *R = wall->pose.rotation;
    demi_persistent_more *more;
    demi_bend b;
    if (!demi_bends[wall->kind]) return;
    memset(&b, 0, sizeof b);
    b.number = c->element;
    b.dist = dist;
    b.normal = demi_unrotate(R, c->normal);
    b.point = demi_unrotate(R, demi_sub(point, wall->pose.position));
    demi_bends[wall->kind](wall, among, count, &b);
    c->bend = b.turn;
    if (b.along < 0 || b.along > 0 || demi_dot(b.axis, b.axis) > 0) {
        more = demi_persistent_odd(c);
        more->along = b.along;
        more->axis = demi_rotate(R, b.axis);
    }
}
