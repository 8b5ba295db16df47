/* ---------------------------------------------------------------------------------------------
   >>surfaces
   One surface per rigid motion. Meshes that do not move relative to each other are joined into one
   surface (>>joins), and so are profiles: grains then do not feel how a scene was divided into
   walls or facets. Walls that different materials ignore are not joined. Facets of a surface share
   whole sides, and each face, edge and corner has an integer weight (>>facets).

   A wall that shares nothing is its own surface. Any other is part of a joined surface
   (wall->joined), which has the form of a wall. Its number as a candidate (>>lists) is wall_count
   or more, and `whose` tells which wall a face, edge or corner belongs to: contacts act on that
   wall and use its material. Surfaces are made again when a wall is added, removed or moved
   otherwise, and when a motion begins. Tessellations of curved walls (>>tessellate) follow the
   joined surfaces: one for each scale of bodies that need it, which is the power of two below their
   radius.
   This part owns w->surfaces and the weights of facets.
   --------------------------------------------------------------------------------------------- */
/* The surface with this number: a wall, or a joined surface. */
DEM_INLINE const demi_wall *demi_surface_of(const dem_world *w, int number) {
    return number < w->wall_count ? &w->walls[number] : &w->surfaces[number - w->wall_count];
}
/* The number of the surface that a wall is part of. */
DEM_INLINE int demi_surface_number(const dem_world *w, int wall) {
    const int joined = w->walls[wall].joined;
    return joined ? w->wall_count + joined - 1 : wall;
}
/* The wall that feature `number` (a face, edge or corner) of a surface belongs to. */
DEM_INLINE int demi_surface_wall(const dem_world *w, const demi_wall *surface, int32_t number) {
    return surface->scale ? surface->lead
        : surface->whose ? surface->whose[number] : (int)(surface - w->walls);
}

/* Makes one surface of the facets: none coincide or cover each other, and none has corners of
   others on its sides. Flat neighbours are merged. Returns 0 if memory ran out. */
static int demi_join_resolve(dem_world *w, demi_join *j) {
    if (!demi_join_double(w, j)) return 0;
    if (!j->facets) return 1;                   /* all lie in planes */
    if (j->per == 3)
        return demi_join_cover(w, j) && demi_join_divide(w, j) &&
            (w->facets_given || demi_join_coarsen(w, j));
    if (!demi_join_divide(w, j) ||              /* then segments that overlap coincide */
        !demi_grow(w, DEMI_LOOSE, &j->mark, 1, (size_t)j->facets) ||
        !demi_grow(w, DEMI_LOOSE, &j->side, sizeof(demi_side), 3*(size_t)j->facets) ||
        !demi_grow(w, DEMI_LOOSE, &j->root, sizeof(int32_t), (size_t)j->facets)) return 0;
    return demi_join_double(w, j);
}
/* True if a plane is in the place of an earlier one that moves with it. */
static int demi_plane_again(const dem_world *w, int wall) {
    const demi_wall *own = &w->walls[wall];
    int i;
    for (i = 0; i < wall && own->kind == DEMI_WALL_PLANE; i++) {
        const demi_wall *a = &w->walls[i];
        const dem_real *R = a->home.rotation, *Q = own->home.rotation;
        const dem_vec3 n = demi_v(R[2], R[5], R[8]), m = demi_v(Q[2], Q[5], Q[8]);
        const dem_vec3 d = demi_sub(own->home.position, a->home.position);
        const dem_real far = demi_length(own->home.position) + demi_length(a->home.position);
        if (a->kind == DEMI_WALL_PLANE && a->group == own->group &&
            demi_length(demi_sub(n, m)) <= DEM_R(1e-6) &&
            DEMI_ABS(demi_dot(n, d)) <= 4*(dem_real)FLT_EPSILON*far) return 1;
    }
    return 0;
}
/* Begins a surface that moves with wall `lead` and has its properties, but no facets. */
static void demi_surface_begin(const dem_world *w, int lead, demi_wall *s) {
    *s = w->walls[lead];
    s->vertex_count = s->edge_count = s->border_count = s->cell_item_count = s->ring_count = 0;
    s->vertices = s->weight = s->planes = 0;
    s->corners = s->edges = s->sheet = s->whose = s->cell_start = s->cell_items = 0;
    s->owns = s->ends = 0;
    s->borders = 0;
    s->motion.table = 0;
    s->chain = DEMI_RUN;
    s->lead = lead;
    s->joined = 0;
    memset(s->cells, 0, sizeof s->cells);
}
/* Completes a surface whose vertices and corners are known, except for `whose` and weights. Returns
   0 if memory ran out. */
static int demi_surface_end(dem_world *w, demi_wall *s) {
    if (!demi_facets_begin(w, s) || !demi_wall_sheets(w, s)) return 0;
    s->number_count = s->element_count + s->edge_count + s->vertex_count;
    demi_wall_bounds(s);
    return demi_wall_index(w, s);
}
/* Writes the joined facets to a surface. Returns 0 if memory ran out. */
static int demi_join_make(dem_world *w, const demi_join *j, demi_wall *s) {
    const dem_pose pose = demi_join_pose(j, &w->walls[j->lead]);
    int32_t *at = (int32_t *)demi_alloc(w, (size_t)j->points, sizeof *at);
    int i, k, ok;
    demi_surface_begin(w, j->lead, s);
    s->element_count = j->facets;
    s->vertices = (dem_real *)demi_hold(w, DEMI_RUN, (size_t)j->points*3, sizeof(dem_real));
    s->corners = (int32_t *)demi_hold(w, DEMI_RUN, (size_t)(j->facets*j->per), sizeof(int32_t));
    ok = at && s->vertices && s->corners;
    for (i = 0; i < j->points && ok; i++) at[i] = -1;
    for (i = 0; i < j->facets && ok; i++)
        for (k = 0; k < j->per; k++) {
            const int32_t p = j->facet[5*i + k];
            if (at[p] < 0) {
                at[p] = s->vertex_count++;
                demi_put(s->vertices + 3*at[p], demi_unrotate(pose.rotation, demi_sub(
                    demi_d3_real(demi_d3_at(j->x + 3*p)), pose.position)));
            }
            s->corners[j->per*i + k] = at[p];
        }
    demi_free(w, at);
    if (!ok || !demi_surface_end(w, s)) return 0;
    s->whose = (int32_t *)demi_hold(w, DEMI_RUN, (size_t)s->number_count, sizeof(int32_t));
    if (!s->whose) return 0;
    for (i = 0; i < s->element_count; i++) {
        int32_t *edge = s->whose + s->element_count, *corner = edge + s->edge_count;
        s->whose[i] = j->facet[5*i + 3];
        for (k = 0; k < j->per; k++) {
            if (s->owns[i] >> k & 1) edge[s->edges[3*i + k]] = j->facet[5*i + 3];
            if (s->owns[i] >> (3 + k) & 1) corner[s->corners[j->per*i + k]] = j->facet[5*i + 3];
        }
    }
    return 1;
}

/* --- weights --- */

/* What meets at the edges and corners of a surface, its periodic images included. Points are the
   surface's corners, then those of images of facets that touch it. */
typedef struct demi_meets_at {
    int points, sides;
    double *x, *near_by;
    int32_t *same, *first;         /* points: the first one here; the corner it is an image of */
    int32_t *faces, *edges;        /* points: facets; sum of the weights of edges */
    demi_side *side;               /* side: that of the facet, + 3 if the facet is an image */
    demi_tree tree;
} demi_meets_at;
static void demi_meets_free(dem_world *w, demi_meets_at *m) {
    demi_free(w, m->x);
    demi_free(w, m->near_by);
    demi_free(w, m->same);
    demi_free(w, m->first);
    demi_free(w, m->faces);
    demi_free(w, m->edges);
    demi_free(w, m->side);
    demi_tree_free(w, &m->tree);
}
/* True if a facet has a size (demi_facets_begin). */
DEM_INLINE int demi_facet_there(const demi_wall *s, int e) { return s->weight[e] > 0; }
/* Adds facet e, its corners at points p, to what meets. */
static void demi_meets_add(const demi_wall *s, demi_meets_at *m, int e, const int32_t *p,
                           int image) {
    const int per = demi_wall_per(s);
    int k;
    for (k = 0; k < per; k++) {
        m->faces[p[k]]++;
        if (per == 3) m->side[m->sides++] = demi_side_of(p[k], p[(k + 1)%3], e, k + 3*image);
    }
}
/* Sets *by, m, to the displacement of the n-th image (0 .. 26; 13 is the surface itself): periodic,
   or a cell of a tessellation. Returns 0 if there is none. */
static int demi_surface_shift(const dem_world *w, const demi_wall *s, int n, demi_d3 *by) {
    const dem_vec3 to = demi_add(demi_scale(s->step[0], (dem_real)(n%3 - 1)),
                                 demi_scale(s->step[1], (dem_real)(n/3%3 - 1)));
    if (!(s->step[0].x > 0)) return demi_join_shift(w, s, n, by);
    *by = demi_d3_of(demi_rotate(s->home.rotation, to));
    return n/9 == 1 && n != 13;
}
/* Adds the images of facets that touch the surface. Returns 0 if memory ran out. */
static int demi_meets_images(dem_world *w, demi_wall *s, demi_meets_at *m) {
    const int per = demi_wall_per(s), own = s->vertex_count;
    int n, e, k, i, pass, images = 0;
    for (pass = 0; pass < 2; pass++) {          /* count, then add */
        for (n = 0; n < 27; n++) {
            demi_d3 by;
            if (!demi_surface_shift(w, s, n, &by)) continue;
            for (e = 0; e < s->element_count; e++) {
                int32_t at[3];
                int touches = 0;
                if (!demi_facet_there(s, e)) continue;
                for (k = 0; k < per; k++) {
                    const int32_t c = s->corners[per*e + k];
                    double x[3];
                    demi_search_line line;
                    int32_t other;
                    demi_d3_put(x, demi_d3_add(demi_d3_at(m->x + 3*c), by));
                    at[k] = -1;
                    demi_tree_line(&line, &m->tree, x, x, m->near_by[c]);
                    while ((other = demi_tree_next(&line)) >= 0 && at[k] < 0) {
                        const double most = DEMI_MIN(m->near_by[c], m->near_by[other]);
                        if (demi_far2(x, m->x + 3*other) <= most*most &&
                            m->faces[m->same[other]]) at[k] = m->same[other];
                    }
                    touches |= at[k] >= 0;
                    if (at[k] >= 0 && pass) m->first[at[k]] = DEMI_MIN(m->first[at[k]], c);
                }
                if (!touches) continue;
                images++;
                for (k = 0; k < per && pass; k++) {
                    double x[3];
                    if (at[k] >= 0) continue;
                    demi_d3_put(x, demi_d3_add(demi_d3_at(m->x + 3*s->corners[per*e + k]), by));
                    for (i = own; i < m->points && !(demi_far2(x, m->x + 3*i) <=
                         m->near_by[i]*m->near_by[i]); i++) continue;
                    at[k] = i;
                    if (i < m->points) continue;
                    memcpy(m->x + 3*i, x, sizeof x);
                    m->near_by[i] = m->near_by[s->corners[per*e + k]];
                    m->points++;
                }
                if (pass) demi_meets_add(s, m, e, at, 1);
            }
        }
        if (pass) break;
        s->wraps = images > 0;
        k = own + 3*images;
        if (!demi_grow(w, DEMI_LOOSE, &m->x, sizeof(double), 3*(size_t)k) ||
            !demi_grow(w, DEMI_LOOSE, &m->near_by, sizeof(double), (size_t)k) ||
            !demi_grow(w, DEMI_LOOSE, &m->faces, sizeof(int32_t), (size_t)k) ||
            !demi_grow(w, DEMI_LOOSE, &m->edges, sizeof(int32_t), (size_t)k) ||
            !demi_grow(w, DEMI_LOOSE, &m->side, sizeof(demi_side),
                       3*((size_t)s->element_count + (size_t)images))) return 0;
    }
    return 1;
}
/* Computes the weights of the edges and corners of a surface, and where it ends. An edge or corner
   that is a periodic image of another one of this surface leaves its weight to the first of them.
   Returns 0 if memory ran out. */
static int demi_surface_weigh(dem_world *w, demi_wall *s) {
    const int per = demi_wall_per(s), all = s->element_count, own = s->vertex_count;
    const int repeats = s->repeats[0] || s->repeats[1] || s->repeats[2] || s->step[0].x > 0;
    dem_real *edge = s->weight + all, *corner = edge + s->edge_count;
    demi_meets_at m;
    int i, k, end, ok;
    memset(&m, 0, sizeof m);
    s->lone = !repeats;
    s->wraps = s->open = 0;
    memset(s->ends, 0, (size_t)all);
    s->number_count = all + s->edge_count + own;
    m.points = own;
    m.first = (int32_t *)demi_alloc(w, (size_t)own, sizeof(int32_t));
    m.faces = (int32_t *)demi_alloc(w, (size_t)own, sizeof(int32_t));
    m.edges = (int32_t *)demi_alloc(w, (size_t)own, sizeof(int32_t));
    m.side = (demi_side *)demi_alloc(w, (size_t)all*3, sizeof(demi_side));
    ok = m.first && m.faces && m.edges && m.side;
    for (i = 0; i < own && ok; i++) m.first[i] = i;
    for (i = 0; i < all && ok; i++)
        if (demi_facet_there(s, i)) demi_meets_add(s, &m, i, s->corners + per*i, 0);
    if (ok && repeats) {
        m.x = (double *)demi_alloc(w, (size_t)own*3, sizeof(double));
        m.near_by = (double *)demi_alloc(w, (size_t)own, sizeof(double));
        m.same = (int32_t *)demi_alloc(w, (size_t)own, sizeof(int32_t));
        ok = m.x && m.near_by && m.same;
        for (i = 0; i < own && ok; i++)
            demi_d3_put(m.x + 3*i, demi_d3_of(demi_add(s->home.position, demi_rotate(
                s->home.rotation, demi_at(s->vertices + 3*i)))));
        if (ok) demi_near_by(m.x, s, 0, m.near_by);
        ok = ok && demi_tree_make(w, &m.tree, m.x, own);
        if (ok) demi_points_weld(&m.tree, m.near_by, m.same);
        ok = ok && demi_meets_images(w, s, &m);
    }
    if (ok) qsort(m.side, (size_t)m.sides, sizeof *m.side, demi_side_compare);
    for (i = 0; i < m.sides && ok; i = end) {
        int32_t first = INT_MAX, e;
        int count;
        end = demi_sides_end(m.side, m.sides, i);
        count = end - i;
        m.edges[m.side[i].lo] += 1 - count;
        m.edges[m.side[i].hi] += 1 - count;
        for (k = i; k < end; k++) {
            e = s->edges[3*m.side[k].facet + m.side[k].side%3];
            first = DEMI_MIN(first, e);
        }
        for (k = i; k < end; k++) {
            const demi_side *at = m.side + k;
            if (at->side >= 3) continue;
            e = s->edges[3*at->facet + at->side];
            edge[e] = e == first ? (dem_real)(1 - count) : 0;
            if (count != 2)
                s->ends[at->facet] = (unsigned char)(s->ends[at->facet] | 1 << at->side);
        }
    }
    for (i = 0; i < own && ok; i++)
        corner[i] = m.faces[i] && m.first[i] == i ? (dem_real)(1 - m.faces[i] - m.edges[i]) : 0;
    for (i = 0; i < 2*all && ok && per == 2; i++)
        if (m.faces[s->corners[i]] != 2)
            s->ends[i/2] = (unsigned char)(s->ends[i/2] | 1 << i%2);
    s->open = s->wraps && !(s->step[0].x > 0);  /* a sheet without end has no open edges */
    for (i = 0; i < all && ok; i++) s->open |= s->ends[i] != 0;
    demi_meets_free(w, &m);
    return ok;
}

/* --- tessellations of curved walls --- */

/* The scale of a body's radius, m: the power of two below it, as a bit of effects.scales. */
static int demi_scale_bit(dem_real radius) {
    int power;
    frexp((double)radius, &power);
    return DEMI_MAX(DEMI_MIN(power + 40, 63), 0);
}
/* True if body i needs the tessellation of a wall: one of its parts has no closed form with it. A
   union with an ellipsoid then has facets for all its parts. */
static int demi_needs_facets(const dem_world *w, const demi_wall *wall, int i) {
    const demi_shape *shape = w->bodies.shaped ? demi_shape_of(w, i) : 0;
    const int pieces = shape && shape->pieces ? shape->pieces : 1;
    int k;
    for (k = 0; k < pieces && shape; k++)
        if (demi_wall_faceted(w, wall, shape->pieces ? w->shapes[shape->piece[k].shape].kind
                              : shape->kind)) return 1;
    return 0;
}
/* The number of the surface on which body i touches a wall. */
static int demi_surface_for(const dem_world *w, int wall, int i) {
    int j = demi_needs_facets(w, &w->walls[wall], i) ? 0 : w->surface_count;
    const int scale = 1 + demi_scale_bit(demi_radius(w, i));
    while (j < w->surface_count && !(w->surfaces[j].scale == scale &&
                                     w->surfaces[j].lead == wall)) j++;
    return j < w->surface_count ? w->wall_count + j : demi_surface_number(w, wall);
}
/* The `scale` (demi_wall) that body i needs for the wall of surface j; 0: it needs no
   tessellation. */
static int demi_surface_scale(const dem_world *w, int j, int i) {
    const demi_wall *s = demi_surface_of(w, j);
    const demi_wall *wall = s->scale ? &w->walls[s->lead] : s;
    return demi_needs_facets(w, wall, i) ? 1 + demi_scale_bit(demi_radius(w, i)) : 0;
}
/* The cell in column u and row v of a tessellation that repeats, and its displacement, m, in the
   frame of the surface. Columns 65,536 apart have the same number: the one next to `at` counts. */
static int32_t demi_cell_pack(double u, double v) {
    const double a = u - 65536*floor(u/65536), b = v - 65536*floor(v/65536);
    return (int32_t)((uint32_t)a << 16 | (uint32_t)b);
}
static dem_vec3 demi_cell_shift(const demi_wall *s, int32_t cell, dem_vec3 at) {
    const double wide = (double)s->step[0].x, skew = (double)s->step[1].x;
    double u = (uint32_t)cell >> 16, v = (uint32_t)cell & 0xffff;
    v += 65536*floor(((double)at.y/(double)s->step[1].y - v)/65536 + 0.5);
    u += 65536*floor((((double)at.x - v*skew)/wide - u)/65536 + 0.5);
    return demi_v((dem_real)(u*wide + v*skew), (dem_real)(v*(double)s->step[1].y), 0);
}
/* Upper bound of the speed, m/s, of what lists hold of wall i; -1 if there is no bound. A rotation
   about its axis of symmetry leaves a wall in place, but not the facets of its tessellations. */
static double demi_wall_pace(const dem_world *w, int i) {
    const demi_wall *wall = &w->walls[i];
    const double turn = (double)demi_length(wall->pose.spin);
    double pace = demi_wall_speed(wall);
    int k;
    for (k = 0; k < w->surface_count && wall->symmetric && turn > 0 && pace >= 0; k++) {
        const demi_wall *s = &w->surfaces[k];
        if (!s->scale || s->lead != i) continue;
        pace = s->step[0].x > 0 ? -1 : DEMI_MAX(pace, turn*(double)s->extent);
    }
    return pace;
}
/* Makes the tessellation of a wall for bodies of one scale. They are in the order of walls, then of
   scales. Returns 0 if memory ran out. */
static int demi_tessellation_make(dem_world *w, int wall, int scale) {
    demi_draft f;
    demi_wall *s;
    int ok;
    if (!DEMI_GROW(w, w->surfaces, (size_t)w->surface_count + 1)) return 0;
    for (s = &w->surfaces[w->surface_count++]; s > w->surfaces && s[-1].scale &&
         (s[-1].lead > wall || (s[-1].lead == wall && s[-1].scale > 1 + scale)); s--) s[0] = s[-1];
    demi_surface_begin(w, wall, s);
    s->scale = 1 + scale;
    demi_draft_begin(&f, w, &w->walls[wall], 5e-4*ldexp(1, scale - 41));
    s->kind = f.per == 3 ? DEMI_WALL_MESH : DEMI_WALL_PROFILE;
    memcpy(s->step, f.step, sizeof s->step);
    s->vertex_count = f.points;
    s->element_count = f.facets;
    s->vertices = (dem_real *)demi_hold(w, DEMI_RUN, (size_t)f.points*3, sizeof(dem_real));
    s->corners = (int32_t *)demi_hold(w, DEMI_RUN, (size_t)(f.facets*f.per), sizeof(int32_t));
    ok = !f.failed && s->vertices && s->corners;
    if (ok) memcpy(s->vertices, f.x, (size_t)f.points*3*sizeof(dem_real));
    if (ok) memcpy(s->corners, f.corner, (size_t)(f.facets*f.per)*sizeof(int32_t));
    demi_draft_free(&f);
    ok = ok && demi_surface_end(w, s) && demi_surface_weigh(w, s);
    s->open = w->walls[wall].open;
    return ok;
}
/* Makes the tessellations for the scales in a set of bits. Returns 0 if memory ran out. */
static int demi_tessellations_make(dem_world *w, uint64_t scales) {
    int i, k, ok = 1;
    for (i = 0; i < w->wall_count && scales; i++)
        for (k = 0; k < 64 && ok; k++)
            if (scales >> k & 1 && demi_wall_tessellates(&w->walls[i]))
                ok = demi_tessellation_make(w, i, k);
    return ok;
}
/* The bit of body i in effects.scales if it needs a tessellation that does not exist, else 0. */
static uint64_t demi_scale_missing(const dem_world *w, int i) {
    const uint64_t bit = UINT64_C(1) << demi_scale_bit(demi_radius(w, i));
    int j;
    for (j = 0; j < w->wall_count && w->bodies.shaped && !(w->effects.scales & bit); j++)
        if (demi_needs_facets(w, &w->walls[j], i)) return bit;
    return 0;
}
/* Makes the tessellations that bodies need and that do not exist yet. Surfaces that exist do not
   change, because slabs share them. Returns 0 if memory ran out. */
static int demi_scales_take(dem_world *w) {
    uint64_t more = 0;
    int i;
    for (i = 0; i < w->bodies.count && w->wall_count && w->bodies.shaped; i++)
        more |= demi_scale_missing(w, i);
    if (!more) return 1;
    w->effects.scales |= more;
    if (!w->facets_valid) return 1;             /* demi_surfaces_make makes all */
    w->facets_valid = demi_tessellations_make(w, more);
    for (i = 0; i < w->surface_count; i++) w->sheeted |= w->surfaces[i].open;
    demi_walls_repeat(w);
    return w->facets_valid;
}

/* --- all surfaces --- */

static void demi_surfaces_free(dem_world *w) {
    int i;
    for (i = 0; i < w->surface_count; i++) demi_wall_free(w, &w->surfaces[i]);
    w->surface_count = 0;
}
/* Joins the walls with wall `lead`, the first of them, and computes the weights of their facets.
   Returns 0 if memory ran out. */
static int demi_surface_make(dem_world *w, int lead) {
    const int per = demi_wall_per(&w->walls[lead]);
    int i, members = 0, ok;
    demi_join j;
    for (i = lead; i < w->wall_count; i++) members += demi_join_member(w, i, lead, per);
    ok = demi_join_begin(w, &j, lead, per);
    if (ok) ok = demi_join_resolve(w, &j);
    for (i = lead; i < w->wall_count; i++)
        if (ok && demi_join_member(w, i, lead, per)) w->walls[i].covered = !j.facets;
    if (ok && j.facets && (j.changed || members > 1)) {
        ok = DEMI_GROW(w, w->surfaces, (size_t)w->surface_count + 1) &&
            demi_join_make(w, &j, &w->surfaces[w->surface_count++]) &&
            demi_surface_weigh(w, &w->surfaces[w->surface_count - 1]);
        for (i = lead; i < w->wall_count && ok; i++)
            if (demi_join_member(w, i, lead, per)) w->walls[i].joined = w->surface_count;
    } else if (ok && j.facets) ok = demi_surface_weigh(w, &w->walls[lead]);
    demi_join_free(w, &j);
    return ok;
}
/* Groups the walls and makes all surfaces again. Returns 0 if memory ran out; the next call then
   tries again. */
static int demi_surfaces_make(dem_world *w) {
    int i, k, ok = 1;
    demi_surfaces_free(w);
    demi_walls_repeat(w);
    for (i = 0; i < w->wall_count; i++) {
        demi_wall *wall = &w->walls[i];
        wall->joined = wall->covered = 0;
        wall->ignorers = demi_ignorers(w, wall->material);
        for (k = 0; k < i; k++)
            if (w->walls[k].kind != DEMI_WALL_NONE && demi_walls_together(&w->walls[k], wall) &&
                w->walls[k].ignorers == wall->ignorers) break;
        wall->group = k;
        wall->covered = demi_plane_again(w, i);
    }
    for (i = 0; i < w->wall_count && ok; i++) {
        if (!demi_faceted(&w->walls[i]) || w->walls[i].joined) continue;
        ok = demi_surface_make(w, i);
    }
    ok = ok && demi_tessellations_make(w, w->effects.scales);
    for (i = w->sheeted = 0; i < w->wall_count + w->surface_count; i++) {
        const demi_wall *s = demi_surface_of(w, i);
        w->sheeted |= s->open && !s->joined && !s->covered;
    }
    demi_walls_repeat(w);                       /* now of the joined ones, too */
    w->facets_valid = ok;
    return ok;
}

/* Returns what changes when the motion of wall `place` begins: 2 surfaces, 1 only groups of walls,
   0 nothing. Relative to walls that are moved alike it remains at rest. */
static int demi_wall_parts(const dem_world *w, int place) {
    const demi_wall *wall = &w->walls[place], *other = w->walls;
    int parts = w->repeating && demi_motion_turns(&wall->motion) ? 2 : 0;
    for (; other < w->walls + w->wall_count; other++)
        if (other->kind != DEMI_WALL_NONE && demi_walls_together(wall, other) &&
            !demi_walls_alike(wall, other))
            parts |= demi_faceted(wall) || demi_faceted(other) || wall->covered || other->covered
                ? 2 : 1;
    return parts;
}
/* Gives another slab the surfaces of the first one of its process, and what these say about the
   walls. Returns 0 if memory ran out. */
static int demi_surfaces_share(dem_world *to, const dem_world *first) {
    int i;
    for (i = 0; i < to->wall_count; i++) {
        const dem_wall_loads loads = to->walls[i].loads;
        to->walls[i] = first->walls[i];
        to->walls[i].loads = loads;
        to->walls[i].motion.kind = DEM_MOTION_FIXED;
    }
    if (!DEMI_COPY(to, to->surfaces, first->surfaces, first->surface_count)) return 0;
    to->surface_count = first->surface_count;
    to->sheeted = first->sheeted;
    to->effects.scales = first->effects.scales;
    return to->facets_valid = 1;
}

/* Here, because it changes which walls form a surface if the materials ignored each other before
   and do not now, or the other way round. Contacts of an ignored pair end with the next list. */
DEM_API dem_result dem_pair_set(dem_world *w, dem_material a, dem_material b, const dem_pair *p) {
    if (demi_null(w, __func__, p, "pair")) return DEM_ERROR_ARGUMENT;
    int i = 0, j = 0;
    char of[48];
    if (demi_material_index(w, __func__, a, &i) || demi_material_index(w, __func__, b, &j))
        return DEM_ERROR_ARGUMENT;
    demi_words(of, sizeof of, " of materials %d and %d", i + 1, j + 1);
    if (demi_rows_check(w, __func__, demi_pair_rows, p, of,
                        "start from dem_pair_get and change only what differs"))
        return DEM_ERROR_ARGUMENT;
    if (p->ignored != demi_ignores(w, i, j)) {
        if (!demi_list_drop(w)) return demi_no_memory(w, __func__);
        demi_surfaces_outdated(w);
    }
    w->pairs[i*DEMI_MATERIALS + j].own = 1;
    demi_pair_put(w, i, j, p);
    demi_pairs_changed(w);
    demi_built(w, __func__);
    return DEM_OK;
}
