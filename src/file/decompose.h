/* ---------------------------------------------------------------------------------------------
   >>decompose
   Clusters: approximation of a closed mesh by overlapping spheres. A grid of points over the mesh's
   bounding box samples inside and outside, by the parity of crossings of lines along z. Candidates
   are spheres about inside points, with five radii from 0.9 to 1.3 times the distance from the
   surface. Each sphere in turn is the candidate that leaves the fewest points wrong. A point is
   wrong if it is in the union of spheres but not in the mesh, or in the mesh but not in the union.
   Then each sphere is removed and chosen again, as long as this reduces the error, for at most
   DEMI_GRAIN_SWEEPS sweeps. This part owns demi_mould. It uses a world only for memory and error
   messages.
   --------------------------------------------------------------------------------------------- */
/* Grid cells along the longest side of the mesh; largest number of candidate points; radii of each;
   sweeps. */
enum { DEMI_GRAIN_CELLS = 40, DEMI_GRAIN_PICKS = 1500, DEMI_GRAIN_SCALES = 5,
       DEMI_GRAIN_SWEEPS = 4 };
/* The grid of points and the candidates. */
typedef struct demi_mould {
    const dem_mesh *mesh;
    const signed char *sign;       /* orientation of each triangle; 0: not counted (>>closed) */
    int n[3], count;               /* points along each axis; all points */
    double lo[3], step;            /* m: lowest corner of the grid, distance between points */
    unsigned char *inside;         /* of each point: 1 inside the mesh, 0 outside */
    uint16_t *covered;             /* of each point: number of spheres that contain it */
    int32_t *pick;                 /* candidates: numbers of their points */
    double *far;                   /* candidates: distance from the surface, m */
    int32_t *most;                 /* picks x scales: the gain of each is at most this + `slack` */
    int picks, slack;              /* candidates; inside points that removals have uncovered */
} demi_mould;
/* Returns the squared distance (m2) of point x from a triangle ([ERI05] 5.1.5). */
static double demi_corner_distance(const demi_d3 *corner, demi_d3 x) {
    const demi_d3 n = demi_d3_normal(corner[0], corner[1], corner[2]);
    double best = 1e300, over;
    int k, in = 1;
    for (k = 0; k < 3; k++) {
        const demi_d3 side = demi_d3_sub(corner[(k + 1)%3], corner[k]);
        const demi_d3 to = demi_d3_sub(x, corner[k]);
        const double l2 = demi_d3_square(side), t = l2 > 0 ? demi_d3_dot(to, side)/l2 : 0;
        const double d2 = demi_d3_square(demi_d3_plus(to, t < 0 ? 0 : t > 1 ? -1 : -t, side));
        in &= demi_d3_dot(demi_d3_cross(side, n), to) <= 0;
        best = DEMI_MIN(best, d2);
    }
    if (!in || !(demi_d3_square(n) > 0)) return best;
    over = demi_d3_dot(demi_d3_sub(x, corner[0]), n);
    return over*over/demi_d3_square(n);
}
/* Returns the distance (m) of point x from the nearest triangle of a mesh. */
static double demi_mesh_distance(const dem_mesh *mesh, demi_d3 x) {
    demi_d3 corner[3];
    double best = 1e300;
    int i;
    for (i = 0; i < mesh->triangle_count; i++) {
        double d;
        demi_mesh_triangle(mesh, i, corner);
        d = demi_corner_distance(corner, x);
        best = DEMI_MIN(best, d);
    }
    return sqrt(best);
}
/* Position of grid point i, m. */
static void demi_mould_at(const demi_mould *m, int i, double *x) {
    x[0] = m->lo[0] + (i%m->n[0] + 0.5)*m->step;
    x[1] = m->lo[1] + (i/m->n[0]%m->n[1] + 0.5)*m->step;
    x[2] = m->lo[2] + (i/m->n[0]/m->n[1] + 0.5)*m->step;
}
/* Swaps inside and outside of all points above a triangle, in the direction of z. */
static void demi_mould_cross(demi_mould *m, int triangle) {
    demi_d3 t[3], a, b, c;
    int from[2], to[2], i, j, k, e;
    demi_mesh_triangle(m->mesh, triangle, t);
    a = t[0]; b = t[1]; c = t[2];
    for (e = 0; e < 2; e++) {
        const double p = e ? a.y : a.x, q = e ? b.y : b.x, r = e ? c.y : c.x;
        const double lo = DEMI_MIN(p, DEMI_MIN(q, r)), hi = DEMI_MAX(p, DEMI_MAX(q, r));
        from[e] = (int)DEMI_MAX(floor((lo - m->lo[e])/m->step - 1), 0);
        to[e] = (int)DEMI_MIN(ceil((hi - m->lo[e])/m->step + 1), m->n[e] - 1);
    }
    for (j = from[1]; j <= to[1]; j++)
        for (i = from[0]; i <= to[0]; i++) {
            const double x = m->lo[0] + (i + 0.5)*m->step, y = m->lo[1] + (j + 0.5)*m->step;
            const double u = (b.x - a.x)*(y - a.y) - (b.y - a.y)*(x - a.x);
            const double v = (c.x - b.x)*(y - b.y) - (c.y - b.y)*(x - b.x);
            const double w = (a.x - c.x)*(y - c.y) - (a.y - c.y)*(x - c.x);
            double z;
            if (!((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0))) continue;
            z = (u*c.z + v*a.z + w*b.z)/(u + v + w);
            for (k = 0; k < m->n[2]; k++)
                if (m->lo[2] + (k + 0.5)*m->step > z)
                    m->inside[i + m->n[0]*(j + m->n[1]*k)] ^= 1;
        }
}
/* With by = 0, returns the gain of adding a sphere of centre c and radius r (m): of the points that
   only this sphere would cover, the number inside the mesh minus the number outside. *right (or
   null) receives the number inside. With by = 1, adds the sphere to `covered`; with by = -1,
   removes it. */
static int demi_mould_gain(demi_mould *m, const double *c, double r, int by, int *right) {
    int from[3], to[3], i[3], e, good = 0, bad = 0;
    for (e = 0; e < 3; e++) {
        from[e] = (int)DEMI_MAX(ceil((c[e] - r - m->lo[e])/m->step - 0.5), 0);
        to[e] = (int)DEMI_MIN(floor((c[e] + r - m->lo[e])/m->step - 0.5), m->n[e] - 1);
    }
    for (i[2] = from[2]; i[2] <= to[2]; i[2]++)
        for (i[1] = from[1]; i[1] <= to[1]; i[1]++) {
            const double y = m->lo[1] + (i[1] + 0.5)*m->step - c[1];
            const double z = m->lo[2] + (i[2] + 0.5)*m->step - c[2], left = r*r - y*y - z*z;
            const int row = m->n[0]*(i[1] + m->n[1]*i[2]);
            for (i[0] = from[0]; i[0] <= to[0] && left > 0; i[0]++) {
                const double x = m->lo[0] + (i[0] + 0.5)*m->step - c[0];
                if (x*x > left) continue;
                if (by) m->covered[row + i[0]] = (uint16_t)(m->covered[row + i[0]] + by);
                else if (!m->covered[row + i[0]]) {
                    good += m->inside[row + i[0]];
                    bad += !m->inside[row + i[0]];
                }
            }
        }
    if (right) *right = good;
    return good - bad;
}
/* Finds the candidate with the largest gain, given the spheres already placed. Writes its centre
   and radius to `sphere` and returns the gain. */
static int demi_mould_best(demi_mould *m, double *sphere) {
    static const double scale[DEMI_GRAIN_SCALES] = {1, 0.9, 1.08, 1.18, 1.3};
    int most = INT_MIN, i, k;
    for (i = 0; i < m->picks; i++)
        for (k = 0; k < DEMI_GRAIN_SCALES; k++) {
            const double r = m->far[i]*scale[k];
            int32_t *bound = m->most + DEMI_GRAIN_SCALES*i + k;
            double c[4];
            int gain, right;
            if (*bound + m->slack <= most) continue;
            demi_mould_at(m, m->pick[i], c);
            gain = demi_mould_gain(m, c, r, 0, &right);
            *bound = right - m->slack;
            if (gain <= most) continue;
            most = gain;
            c[3] = r;
            memcpy(sphere, c, sizeof c);
        }
    return most;
}
/* Makes the grid for a mesh with this bounding box, and the candidates. Returns 0 if memory ran
   out; the caller frees in any case. */
static int demi_mould_make(dem_world *w, demi_mould *m, demi_d3 lowest, demi_d3 highest) {
    double most = 0, x[3], lo[3], hi[3];
    int i, e, inside = 0, seen = 0;
    demi_d3_put(lo, lowest);
    demi_d3_put(hi, highest);
    for (e = 0; e < 3; e++) most = DEMI_MAX(most, hi[e] - lo[e]);
    m->step = most/(int)DEMI_GRAIN_CELLS;
    for (e = 0, m->count = 1; e < 3; e++) {
        m->n[e] = (int)ceil((hi[e] - lo[e])/m->step) + 6;
        /* shifted a little, to keep the lines of the grid off the vertices */
        m->lo[e] = (lo[e] + hi[e])/2 - m->step*(m->n[e]/2.0 + 0.0123*(e + 1));
        m->count *= m->n[e];
    }
    m->inside = (unsigned char *)demi_alloc(w, (size_t)m->count, 1);
    m->covered = (uint16_t *)demi_alloc(w, (size_t)m->count, sizeof(uint16_t));
    m->pick = (int32_t *)demi_alloc(w, DEMI_GRAIN_PICKS, sizeof(int32_t));
    m->far = (double *)demi_alloc(w, DEMI_GRAIN_PICKS, sizeof(double));
    m->most = (int32_t *)demi_alloc(w, DEMI_GRAIN_SCALES*DEMI_GRAIN_PICKS, sizeof(int32_t));
    if (!m->inside || !m->covered || !m->pick || !m->far || !m->most) return 0;
    for (i = 0; i < DEMI_GRAIN_SCALES*DEMI_GRAIN_PICKS; i++) m->most[i] = INT_MAX/2;
    for (i = 0; i < m->mesh->triangle_count; i++) if (m->sign[i]) demi_mould_cross(m, i);
    for (i = 0; i < m->count; i++) inside += m->inside[i];
    for (i = 0; i < m->count; i++) {            /* picks inside points at equal intervals */
        const int64_t now = (int64_t)(seen + 1)*DEMI_GRAIN_PICKS;
        if (!m->inside[i]) continue;
        seen++;
        if (inside > DEMI_GRAIN_PICKS && now/inside == (now - DEMI_GRAIN_PICKS)/inside) continue;
        if (m->picks == DEMI_GRAIN_PICKS) break;
        demi_mould_at(m, i, x);
        m->far[m->picks] = demi_mesh_distance(m->mesh, demi_d3_at(x));
        m->pick[m->picks++] = i;
    }
    return 1;
}
static void demi_mould_free(dem_world *w, demi_mould *m) {
    demi_free(w, m->inside);
    demi_free(w, m->covered);
    demi_free(w, m->pick);
    demi_free(w, m->far);
    demi_free(w, m->most);
}
/* Fills in volume, centre and inertia of a mesh, which are exact, and surface_error, the rms
   distance of its surface from the union of spheres (count x 4: centre, radius). */
static void demi_spheres_judge(const dem_mesh *mesh, const demi_moments *m, const double *sphere,
                               int count, dem_spheres_fit *fit) {
    double c[3], I[6], all = 0, square = 0;
    int i, k, e;
    for (k = 0; k < 3; k++) c[k] = m->x[k]/m->one;
    for (k = 0; k < 6; k++) I[k] = m->xx[k] - m->one*c[demi_sym_row[k]]*c[demi_sym_column[k]];
    fit->volume = (dem_real)m->one;
    fit->centre = demi_d3_real(demi_d3_at(c));
    for (k = 0; k < 3; k++) fit->inertia[k] = (dem_real)(I[(k + 1)%3] + I[(k + 2)%3]);
    for (k = 3; k < 6; k++) fit->inertia[k] = (dem_real)-I[k];
    for (i = 0; i < mesh->triangle_count; i++) {        /* at three points of each triangle */
        demi_d3 x[3];
        double area;
        demi_mesh_triangle(mesh, i, x);
        area = demi_d3_length(demi_d3_normal(x[0], x[1], x[2]))/6;
        for (k = 0; k < 3; k++) {
            const demi_d3 sum = demi_d3_add(demi_d3_add(demi_d3_scale(x[k], 4), x[(k + 1)%3]),
                                            x[(k + 2)%3]);
            double off = 1e300;
            for (e = 0; e < count; e++) {
                const demi_d3 d = demi_d3_sub(demi_d3_over(sum, 6), demi_d3_at(sphere + 4*e));
                const double gap = demi_d3_length(d) - sphere[4*e + 3];
                off = DEMI_MIN(off, gap);
            }
            all += area;
            square += area*off*off;
        }
    }
    fit->surface_error = (dem_real)sqrt(square/all);
}
/* Fills in volume_error, inertia_error and `wrong`: compares the points that spheres cover with the
   points inside the mesh. */
static void demi_mould_judge(const demi_mould *m, dem_spheres_fit *fit) {
    demi_moments own, theirs;
    double x[3], worst = 0, spread[2][3];
    int i, k, wrong = 0, inside = 0;
    memset(&own, 0, sizeof own);
    memset(&theirs, 0, sizeof theirs);
    for (i = 0; i < m->count; i++) {
        demi_mould_at(m, i, x);
        demi_d3_put(x, demi_d3_sub(demi_d3_at(x), demi_d3_of(fit->centre)));
        if (m->inside[i]) demi_moments_add(&own, 1, x, 0);
        if (m->covered[i]) demi_moments_add(&theirs, 1, x, 0);
        wrong += (m->inside[i] != 0) != (m->covered[i] != 0);
        inside += m->inside[i];
    }
    for (k = 0; k < 3; k++) {
        spread[0][k] = own.xx[(k + 1)%3] + own.xx[(k + 2)%3];
        spread[1][k] = theirs.xx[(k + 1)%3] + theirs.xx[(k + 2)%3];
        worst = DEMI_MAX(worst, fabs(spread[1][k]/spread[0][k] - 1));
    }
    fit->volume_error = (dem_real)(theirs.one/own.one - 1);
    fit->inertia_error = (dem_real)worst;
    fit->wrong = (dem_real)((double)wrong/inside);
}
/* Does the work of dem_mesh_spheres, for checked arguments. sign: the orientation of each triangle
   (>>closed). */
static dem_result demi_mesh_spheres(dem_world *w, const char *call, const dem_mesh *mesh,
                                    const signed char *sign, int count, dem_real *positions,
                                    dem_real *radii, dem_spheres_fit *fit) {
    dem_spheres_fit told;
    demi_moments moments;
    demi_mould m;
    demi_d3 lo = demi_d(1e300, 1e300, 1e300), hi = demi_d(-1e300, -1e300, -1e300), x[3];
    double *sphere;
    int i, k, sweep, changed = 1, made;
    memset(&moments, 0, sizeof moments);
    for (i = 0; i < mesh->triangle_count; i++) {
        demi_mesh_triangle(mesh, i, x);
        if (sign[i] > 0) demi_moments_tetrahedron(&moments, x[0], x[1], x[2]);
        if (sign[i] < 0) demi_moments_tetrahedron(&moments, x[0], x[2], x[1]);
        for (k = 0; k < 3; k++) {
            lo = demi_d3_lowest(lo, x[k]);
            hi = demi_d3_highest(hi, x[k]);
        }
    }
    if (!(moments.one > 1e-6*(hi.x - lo.x)*(hi.y - lo.y)*(hi.z - lo.z)))
        return demi_refuse(w, call, "the mesh of %d triangles encloses %.3g m3, must be more than "
                           "1e-6 of its box: it is too thin for spheres; is it a sheet?",
                           mesh->triangle_count, moments.one);
    memset(&m, 0, sizeof m);
    m.mesh = mesh;
    m.sign = sign;
    sphere = (double *)demi_alloc(w, 4*(size_t)count, sizeof(double));
    made = sphere && demi_mould_make(w, &m, lo, hi);
    if (!made || !m.picks) {
        demi_mould_free(w, &m);
        demi_free(w, sphere);
        if (!made) return demi_no_memory(w, call);
        return demi_refuse(w, call, "the mesh is thinner than 1/%d of its length everywhere, so no "
                           "sphere fits; use a polyhedron, or a thicker mesh",
                           (int)DEMI_GRAIN_CELLS);
    }
    for (i = 0; i < count; i++) {
        demi_mould_best(&m, sphere + 4*i);
        demi_mould_gain(&m, sphere + 4*i, sphere[4*i + 3], 1, 0);
    }
    for (sweep = 0; sweep < DEMI_GRAIN_SWEEPS && changed; sweep++)
        for (i = 0, changed = 0; i < count; i++) {
            double other[4];
            int had, right;
            demi_mould_gain(&m, sphere + 4*i, sphere[4*i + 3], -1, 0);
            had = demi_mould_gain(&m, sphere + 4*i, sphere[4*i + 3], 0, &right);
            m.slack += right;
            if (demi_mould_best(&m, other) > had) {
                memcpy(sphere + 4*i, other, sizeof other);
                changed = 1;
            }
            demi_mould_gain(&m, sphere + 4*i, sphere[4*i + 3], 1, 0);
        }
    memset(&told, 0, sizeof told);
    demi_spheres_judge(mesh, &moments, sphere, count, &told);
    demi_mould_judge(&m, &told);
    for (i = 0; i < count; i++) {
        for (k = 0; k < 3; k++) positions[3*i + k] = (dem_real)sphere[4*i + k];
        radii[i] = (dem_real)sphere[4*i + 3];
    }
    if (fit) *fit = told;
    demi_mould_free(w, &m);
    demi_free(w, sphere);
    return DEM_OK;
}
DEM_API dem_result dem_mesh_spheres(dem_world *w, const dem_mesh *mesh, int count,
                                    dem_real *positions, dem_real *radii, dem_spheres_fit *fit) {
    demi_closed c;
    dem_result result = DEM_ERROR_ARGUMENT;
    if (demi_null_write(w, __func__, mesh, "mesh") || demi_null_look(w, __func__, radii, "radii") ||
        demi_null_look(w, __func__, positions, "positions")) return result;
    if (count < 1 || count > 1000)
        return demi_fail(w, result, "%s: count is %d, must be 1 to 1000", __func__, count);
    if (!demi_mesh_sound(w, __func__, mesh->vertex_count, mesh->vertices, 3, mesh->triangle_count,
                         mesh->triangles, 3)) return result;
    if (!demi_closed_find(w, mesh, &c)) result = demi_no_memory(w, __func__);
    else if (demi_closed_body(w, __func__, &c))
        result = demi_mesh_spheres(w, __func__, mesh, c.sign, count, positions, radii, fit);
    demi_closed_free(w, &c);
    return result;
}
