/* ---------------------------------------------------------------------------------------------
   >>search
   Broad phase of contact detection: finds the candidate pairs, which may touch before the next
   rebuild. These are all pairs with distance < Ra + Rb + skin (+ range of the law). There are
   several search methods. Each stores pairs in the same canonical order (a ascending, then b), so
   every method gives the same list and the same bits. A rebuild sorts bodies by cell, divides them
   into work groups (of about 2000 spheres), and lists for each group the pairs inside it and the
   pairs with later groups. Then it moves the contact histories to the new lists and lists the wall
   elements near each grain (>>lists, >>rebuild). This part writes the cells, levels, bins and the
   linked linear list of dem_world, the order of bodies, and the candidate pairs.
   --------------------------------------------------------------------------------------------- */

/* Row of a body in an array of four reals per body. An unsigned index saves a sign extension. */
#define DEMI_AT(array, body) ((array) + 4*(size_t)(uint32_t)(body))

/* Divides a box into cells of at least `least` (m) on each axis, along x of at least slant times
   that, and at most about 4*count cells. */
static void demi_cells_lay(const double *lo, const double *hi, double least, double slant,
                           int count, int *cells, double *size) {
    int k;
    for (;; least *= 1.26) {
        for (k = 0; k < 3; k++)
            cells[k] = (int)DEMI_MAX(1, DEMI_MIN((hi[k] - lo[k])/(k ? least : least*slant), 1e6));
        if ((double)cells[0]*cells[1]*cells[2] <= 4.0*count + 64) break;
    }
    for (k = 0; k < 3; k++) size[k] = DEMI_MAX((hi[k] - lo[k])/cells[k], least*1e-9);
}
/* Returns the cell of position x; outside the grid, the nearest cell. Cell numbers increase fastest
   along axes[0], then along axes[1]. */
static int demi_cell_of(const demi_periods *p, const double *origin, const double *size,
                        const int *cells, const int *axes, const dem_real *x) {
    int c[3], k;
    for (k = 0; k < 3; k++) {
        const double t = ((k ? (double)x[k] : demi_upright(p, x)) - origin[k])/size[k];
        c[k] = !(t > 0) ? 0 : t >= cells[k] ? cells[k] - 1 : (int)t;
    }
    return c[axes[0]] + cells[axes[0]]*(c[axes[1]] + cells[axes[1]]*c[axes[2]]);
}
/* Sorts the axes by their number of cells, ascending, so that cell numbers increase slowest along
   the axis with the most cells. Work groups, which are ranges of this order, are then thick slices
   with few pairs between them, even in flat scenes. */
static void demi_axes_order(const int *cells, int *axes) {
    int k;
    for (k = 0; k < 3; k++) axes[k] = k;
    for (k = 0; k < 3; k++) {                   /* exchanges of neighbours, (0 1) (1 2) (0 1) */
        int *pair = axes + k%2, first = pair[0];
        if (cells[first] <= cells[pair[1]]) continue;
        pair[0] = pair[1];
        pair[1] = first;
    }
}

/* Sets up the grid by which bodies are sorted, and computes the cell of each body. least: m,
   smallest cell. Returns 0 if memory runs out. */
static int demi_grid_lay(dem_world *w, double least) {
    const demi_periods p = demi_periods_of(w);
    double lo[3], hi[3];
    int i, k, n;
    demi_domain_limits(w, lo, hi);
    for (k = 0; k < 3; k++) {
        const int periodic = w->desc.boundary[k] == DEM_BOUNDARY_PERIODIC;
        if (periodic) continue;
        lo[k] = w->bodies.count ? (double)w->bodies.pos[k] : 0;
        hi[k] = lo[k];
        for (i = 1; i < w->bodies.count; i++) {
            const double x = (double)w->bodies.pos[4*i + k];
            lo[k] = DEMI_MIN(lo[k], x);
            hi[k] = DEMI_MAX(hi[k], x);
        }
    }
    demi_cells_lay(lo, hi, least, demi_slant(&p), w->bodies.count, w->cells, w->cell_size);
    demi_axes_order(w->cells, w->cell_axes);
    for (k = 0; k < 3; k++) w->cell_origin[k] = lo[k];
    n = w->cells[0]*w->cells[1]*w->cells[2];
    if (!DEMI_GROW(w, w->cell_start, (size_t)n + 2)) return 0;
    for (i = 0; i < w->bodies.count; i++)
        w->bodies.cell_of[i] =
            demi_cell_of(&p, w->cell_origin, w->cell_size, w->cells, w->cell_axes,
                         w->bodies.pos + 4*i);
    return 1;
}

/* Permutes one array of bodies into the order of bodies.order. The sizes that occur are written
   out, because a memcpy of constant length compiles to instructions, any other to a call. */
static void demi_permute(dem_world *w, const demi_body_array *a) {
    char *to = (char *)w->bodies.scratch;
    const char *from = demi_data(w, a);
    const size_t n = (size_t)w->bodies.count, item = demi_item(w, a);
    size_t i, k;
#define DEMI_PERMUTE(size) \
    for (i = 0; i < n; i++) memcpy(to + i*(size), from + (size_t)w->bodies.order[i]*(size), size)
    if (item == 4*sizeof(dem_real)) DEMI_PERMUTE(4*sizeof(dem_real));
    else if (item == sizeof(dem_real)) DEMI_PERMUTE(sizeof(dem_real));
    else if (item == sizeof(int32_t)) DEMI_PERMUTE(sizeof(int32_t));
    else {                                      /* in pieces: scratch holds four reals per body */
        for (k = 0; k < item; k += 4*sizeof(dem_real)) {
            const size_t piece = DEMI_MIN(item - k, 4*sizeof(dem_real));
            char *back = demi_data(w, a) + k;
            for (i = 0; i < n; i++)
                memcpy(to + i*piece, from + (size_t)w->bodies.order[i]*item + k, piece);
            for (i = 0; i < n; i++) memcpy(back + i*item, to + i*piece, piece);
        }
        return;
    }
#undef DEMI_PERMUTE
    memcpy(demi_data(w, a), to, n*item);
}
/* Counting sort: puts the bodies of cell c, in their present order, at order[start[c]] ..
   order[start[c + 1] - 1], for n cells. Returns 1 if bodies were sorted already. */
static int demi_cells_fill(dem_world *w, int n) {
    int32_t *start = w->cell_start;
    int i, sorted = 1;
    memset(start, 0, ((size_t)n + 2)*sizeof(int32_t));
    for (i = 0; i < w->bodies.count; i++) {
        start[w->bodies.cell_of[i] + 2]++;
        if (i && w->bodies.cell_of[i] < w->bodies.cell_of[i - 1]) sorted = 0;
    }
    for (i = 2; i < n + 2; i++) start[i] += start[i - 1];
    for (i = 0; i < w->bodies.count; i++) w->bodies.order[start[w->bodies.cell_of[i] + 1]++] = i;
    return sorted;
}
/* Sorts bodies by cell. The sort is stable: bodies of a cell keep their order. */
static void demi_bodies_sort(dem_world *w) {
    int i;
    if (demi_cells_fill(w, w->cells[0]*w->cells[1]*w->cells[2])) return;
    for (i = 0; i < DEMI_BODY_ARRAYS; i++) {
        const demi_body_array *a = &demi_body_arrays[i];
        if (demi_keeps(w, a)) demi_permute(w, a);
    }
    for (i = 0; i < w->bodies.count; i++) w->bodies.slot_index[w->bodies.slot[i]] = i;
}

/* Returns the index of the saved contact history (demi_filed) of entry `at` of the pruned list, or
   -1. *flip receives 1 if a and b have exchanged their roles since. */
static int demi_carry_find(const dem_world *w, size_t at, int *flip) {
    const int32_t sa = (int32_t)w->bodies.slot[w->near.a[at]];
    const int32_t sb = (int32_t)w->bodies.slot[w->near.b[at]];
    const int32_t row = DEMI_MIN(sa, sb), other = DEMI_MAX(sa, sb);
    const int32_t part = demi_near_part_key(w, at);
    int k;
    if (!w->filed.count || row >= w->filed.rows) return -1;
    if (w->filed.stride != w->memory_stride) return -1;     /* saved under other laws: invalid */
    for (k = w->filed.start[row]; k < w->filed.start[row + 1]; k++) {
        const int32_t p = w->filed.partner[k];
        if (w->filed.part[k] != part) continue;
        if (p == other) { *flip = sa > sb; return k; }
        if (p == ~other) { *flip = sa < sb; return k; }
    }
    return -1;
}

/* Returns the offset in image_shift of b's image nearest to a. It is valid until the next list,
   because positions are wrapped into the periodic box only at a rebuild, and a period is at least
   twice as long as the largest diameter and the skin (demi_periods_refuse). */
static unsigned char demi_pair_image(const dem_world *w, const demi_periods *p, int a, int b) {
    const dem_real *x = w->bodies.pos + 4*a, *y = w->bodies.pos + 4*b;
    int code = 0, e, weight = 4;
    for (e = 0; e < 3; e++, weight *= 3) {
        const dem_real d = y[e] - x[e];
        code += d < -p->half[e] ? weight : d > p->half[e] ? 2*weight : 0;
    }
    if (p->offset < 0 || p->offset > 0) {       /* x again, after the displacement along it */
        const int up = code/12%3;
        const dem_real d = y[0] - x[0] + (up == 1 ? p->offset : up == 2 ? -p->offset : 0);
        code += (d < -p->half[0] ? 4 : d > p->half[0] ? 8 : 0) - code%12;
    }
    return (unsigned char)code;
}
/* Computes the shifts, m, to the 27 images of a body. Candidates store the offset of theirs in a
   byte. */
static void demi_image_shifts(dem_world *w) {
    const demi_periods p = demi_periods_of(w);
    int code, e;
    for (code = 0; code < 27; code++)
        for (e = 0; e < 3; e++) {
            const int c = code/(e == 0 ? 1 : e == 1 ? 3 : 9)%3;
            w->image_shift[4*code + e] = c == 0 ? 0 : c == 1 ? p.period[e] : -p.period[e];
            if (e == 1 && c) w->image_shift[4*code] += c == 1 ? p.offset : -p.offset;
        }
}

/* True if the gap of two bodies along the line of their centres is below `skin`. A sharper test
   than bounding spheres for long bodies. gap: vector from a's centre to b's. */
static int demi_pair_reaches(const dem_world *w, int a, int b, dem_vec3 gap, dem_real skin) {
    const dem_real d = demi_length(gap);
    dem_vec3 n;
    if (!(d > 0)) return 1;
    n = demi_scale(gap, 1/d);
    return d - demi_support(w, a, n) - demi_support(w, b, demi_scale(n, -1)) < skin;
}

/* Tests one pair (a < b) and appends it to the list of a's work group d if its gap is below `skin`.
   Leaves out pairs of two fixed bodies, of two ghosts, of materials that ignore each other. */
static void demi_pair_offer(dem_world *w, int d, const demi_periods *p, dem_real skin, int a,
                            int b) {
    const dem_real *x = w->bodies.pos + 4*a, *y = w->bodies.pos + 4*b;
    const dem_real up = y[1] - x[1];
    const dem_real slid = up < -p->half[1] ? p->offset : up > p->half[1] ? -p->offset : 0;
    const dem_real dx = demi_image(y[0] - x[0] + slid, p->half[0], p->period[0]);
    const dem_real dy = demi_image(up, p->half[1], p->period[1]);
    const dem_real dz = demi_image(y[2] - x[2], p->half[2], p->period[2]);
    const dem_real cut = x[3] + y[3] + skin;
    demi_domain *domain = &w->domains[d];
    demi_list *list;
    int k;
    if (!(dx*dx + dy*dy + dz*dz < cut*cut)) return;
    if (w->effects.fixed_count && w->bodies.inv_mass[a] <= 0 && w->bodies.inv_mass[b] <= 0) return;
    if (demi_is_ghost(w, a) && demi_is_ghost(w, b)) return;
    if (w->effects.ignoring &&
        demi_ignores(w, w->bodies.material[a] - 1, w->bodies.material[b] - 1)) return;
    if (w->effects.tight && !demi_pair_reaches(w, a, b, demi_v(dx, dy, dz), skin)) return;
    list = b < domain->end ? &w->own : &w->cross;
    k = list == &w->own ? domain->own : domain->cross;
    if (k >= list->stride) { domain->overflow |= list == &w->own ? 1 : 2; return; }
    if (list == &w->own) domain->own++; else domain->cross++;
    k += d*list->stride;
    list->a[k] = a;
    list->b[k] = b;
    list->image[k] = demi_pair_image(w, p, a, b);
}

/* --- search methods. For every body a of work group d, in turn, each calls demi_pair_offer with
       the possible partners b > a in ascending order. --- */

/* All pairs: slow, and so simple that the other methods are tested against it. */
static void demi_rows_all_pairs(dem_world *w, int d) {
    const demi_periods p = demi_periods_of(w);
    int a, b;
    for (a = w->domains[d].begin; a < w->domains[d].end; a++)
        for (b = a + 1; b < w->bodies.count; b++)
            demi_pair_offer(w, d, &p, demi_cover(w), a, b);
}

/* Stores the cell indices c - 1, c, c + 1 along an axis of n cells, ascending and without
   duplicates. On a periodic axis they wrap, otherwise those outside are left out. Returns their
   number. */
static int demi_neighbours(int c, int n, int periodic, int *out) {
    int count = 0, k, j;
    for (k = -1; k <= 1; k++) {
        int q = c + k, seen = 0;
        if (q < 0 || q >= n) {
            if (!periodic) continue;
            q = (q + n)%n;
        }
        for (j = 0; j < count; j++) seen |= out[j] == q;
        if (!seen) out[count++] = q;
    }
    for (k = 1; k < count; k++)                 /* sorts at most three */
        for (j = k; j > 0 && out[j] < out[j - 1]; j--) { int t = out[j]; out[j] = out[j - 1];
                                                        out[j - 1] = t; }
    return count;
}

/* Uniform grid (linked cells). Bodies are sorted by cell, so a cell is a range of indices, and
   neighbouring cells along the first axis are often a single range. Each pair is found once: from
   the body in the lower cell or, in the same cell, from the lower index. */
static void demi_rows_grid(dem_world *w, int d) {
    const demi_periods p = demi_periods_of(w);
    const dem_real cover = demi_cover(w);
    const int32_t *start = w->cell_start;
    int n[3], wraps[3];
    int a, c, i, j, k, b, last = -1, ranges = 0;
    int32_t from[27], to[27];
    for (k = 0; k < 3; k++) {
        n[k] = w->cells[w->cell_axes[k]];
        wraps[k] = w->desc.boundary[w->cell_axes[k]] == DEM_BOUNDARY_PERIODIC;
    }
    for (a = w->domains[d].begin; a < w->domains[d].end; a++) {
        c = w->bodies.cell_of[w->bodies.order[a]];
        if (c != last) {  /* all bodies of a cell search the same ranges */
            int at[3][3];
            const int mx = demi_neighbours(c%n[0], n[0], wraps[0], at[0]);
            const int my = demi_neighbours(c/n[0]%n[1], n[1], wraps[1], at[1]);
            const int mz = demi_neighbours(c/n[0]/n[1], n[2], wraps[2], at[2]);
            ranges = 0;
            for (k = 0; k < mz; k++)
                for (j = 0; j < my; j++)
                    for (i = 0; i < mx; i++) {
                        const int q = at[0][i] + n[0]*(at[1][j] + n[1]*at[2][k]);
                        if (q < c || start[q] == start[q + 1]) continue;
                        if (ranges && to[ranges - 1] == start[q]) { to[ranges - 1] = start[q + 1];
                            continue; }
                        from[ranges] = start[q];
                        to[ranges++] = start[q + 1];
                    }
            last = c;
        }
        for (k = 0; k < ranges; k++)
            for (b = DEMI_MAX(from[k], a + 1); b < to[k];
                 b++) demi_pair_offer(w, d, &p, cover, a, b);
    }
}

/* --- levels: a hierarchical grid [OGA12] for bodies of very different radii. The cells of a single
       grid, as wide as the largest body, would each hold thousands of small bodies. Here radii are
       divided into classes, and each class (level) has its own grid, whose cells hold one or two of
       its bodies. A body searches every level within its own reach: few cells of the coarser
       levels, and the cells near its surface in the finer ones. Partners with a higher index are
       collected and sorted, so each pair is found once, from its lower index. (In [OGA12] only
       small bodies search, for larger ones; here each row of a work group must be in order.) --- */

/* Estimates the work of a search, in distance tests, for one level: `count` bodies of radius up to
   `radius` (m) in a packing of volume `room`, with `finer` bodies in the finer levels. A body of
   the level searches 27 cells of it (9 in a plane), and half of the partners have a higher index.
   Pairs with finer bodies cost about half of that. Every body that searches the level costs some 10
   tests more. */
static double demi_level_work(const dem_world *w, double radius, double room, double count,
                              double finer) {
    const double side = 2*radius + (double)demi_cover(w), all = w->desc.planar ? 9 : 27;
    const double cell = w->desc.planar ? side*side : side*side*side;
    const double part = DEMI_MIN(cell/DEMI_MAX(room, 1e-300), 1/all);
    return count*part*(0.5*all*count + 0.25*all*finer) + 10*(count + finer);
}

/* Counts bodies by class of radius: class k is radius_max/2^(k/2) down to a factor sqrt 2 less.
   top[k]: m, largest radius of class k; below[k]: bodies in class k and finer ones. Returns the
   total volume of the cubes (planar: squares) around all bodies. */
static double demi_radii_count(const dem_world *w, double *top, int *below) {
    double limit[DEMI_LEVELS], room = 0;
    int i, k;
    for (k = 0; k < DEMI_LEVELS; k++) {
        limit[k] = k < 2 ? (double)w->effects.radius_max*(k ? 0.70710678118654752 : 1)
            : limit[k - 2]/2;
        top[k] = 0;
        below[k] = 0;
    }
    /* neighbours in the arrays are often alike: starts from the last k */
    for (i = 0, k = 0; i < w->bodies.count; i++) {
        const double r = (double)demi_radius(w, i), side = 2*r;
        while (k > 0 && r > limit[k]) k--;
        while (k < DEMI_LEVELS - 1 && r <= limit[k + 1]) k++;
        below[k]++;
        top[k] = DEMI_MAX(top[k], r);
        room += w->desc.planar ? side*side : side*side*side;
    }
    for (k = DEMI_LEVELS - 1; k >= 0; k--) below[k] += below[k + 1];
    return room;
}

/* Chooses how to join the classes into levels at the lowest cost (by dynamic programming), whether
   levels are cheaper than one grid, and the method if desc.search is AUTO. The choice depends only
   on radii and the skin, and bodies are sorted in the same way for every method, so all methods
   give the same bits. */
static void demi_levels_choose(dem_world *w) {
    double top[DEMI_LEVELS], least[DEMI_LEVELS + 1], room, one;
    int below[DEMI_LEVELS + 1], next[DEMI_LEVELS + 1], i, k;
    const int alike = w->effects.radius_max <= 2*w->effects.radius_min;    /* one grid suffices */
    const int by_name = w->desc.search == DEM_SEARCH_HIERARCHICAL &&
    w->asked.search != DEM_SEARCH_AUTO;
    w->levels.wide = w->levels.count = 0;
    w->levels.tests[0] = w->levels.tests[1] = 0;
    if (w->asked.search == DEM_SEARCH_AUTO) w->desc.search = DEM_SEARCH_GRID;
    if (!w->bodies.count || (alike && !by_name)) return;
    below[DEMI_LEVELS] = 0;
    room = demi_radii_count(w, top, below);
    least[DEMI_LEVELS] = 0;
    for (i = DEMI_LEVELS - 1; i >= 0; i--) {  /* cheapest division of classes i and finer */
        least[i] = least[i + 1];
        next[i] = i + 1;
        if (below[i] == below[i + 1]) continue;
        for (k = i + 1; k <= DEMI_LEVELS; k++) {
            const double work = least[k] + demi_level_work(w, top[i], room, below[i] - below[k],
                                                           below[k]);
            if (k > i + 1 && !(work < least[i])) continue;
            least[i] = work;
            next[i] = k;
        }
    }
    for (i = 0; i < DEMI_LEVELS; i = next[i]) {
        if (below[i] == below[next[i]]) continue;
        w->levels.level[w->levels.count].radius = w->levels.fine = top[i];
        w->levels.level[w->levels.count++].count = below[i] - below[next[i]];
    }
    one = demi_level_work(w, (double)w->effects.radius_max, room, w->bodies.count, 0);
    w->levels.wide = !alike && w->levels.count > 1 && 2*least[0] < one;
    w->levels.tests[0] = one/w->bodies.count;
    w->levels.tests[1] = least[0]/w->bodies.count;
    if (w->asked.search == DEM_SEARCH_AUTO &&
        w->levels.wide) w->desc.search = DEM_SEARCH_HIERARCHICAL;
    if (w->desc.search == DEM_SEARCH_HIERARCHICAL) return;
    /* with wide radii, bodies are sorted by cells finer than those of a uniform grid; then the
       requested grid is a single level */
    w->levels.count = w->levels.wide && w->desc.search == DEM_SEARCH_GRID;
    w->levels.level[0].radius = (double)w->effects.radius_max;
    w->levels.level[0].count = w->bodies.count;
}

/* Sets up the cells of all levels and assigns the sorted bodies to them. Reuses the arrays of the
   sort. Returns 0 if memory runs out. */
static int demi_levels_lay(dem_world *w) {
    static const int along[3] = {0, 1, 2};
    const demi_periods p = demi_periods_of(w);
    double hi[3];
    int i, k, l, n = 0;
    for (k = 0; k < 3; k++) hi[k] = w->cell_origin[k] + w->cell_size[k]*w->cells[k];
    for (l = 0; l < w->levels.count; l++) {
        demi_level *level = &w->levels.level[l];
        demi_cells_lay(w->cell_origin, hi, 2*level->radius + (double)demi_cover(w) + 1e-300,
                       demi_slant(&p), level->count, level->cells, level->size);
        level->first = n;
        n += level->cells[0]*level->cells[1]*level->cells[2];
    }
    if (!DEMI_GROW(w, w->cell_start, (size_t)n + 2)) return 0;
    for (i = 0; i < w->bodies.count; i++) {
        const demi_level *level = w->levels.level;
        while (level < w->levels.level + w->levels.count - 1 &&
               (double)demi_radius(w, i) <= level[1].radius)
            level++;
        w->bodies.cell_of[i] = level->first +
            demi_cell_of(&p, w->cell_origin, level->size, level->cells, along, w->bodies.pos + 4*i);
    }
    demi_cells_fill(w, n);
    return 1;
}

/* A range of cells of a level along one axis. On a periodic axis it may extend beyond the ends; if
   it covers the whole period, it contains each cell once and `round` is 1. */
typedef struct demi_stretch { int first, last, round; } demi_stretch;
/* Returns the cells of a level along one axis within `reach` (m) of x. */
static demi_stretch demi_level_span(const dem_world *w, const demi_level *level, int axis, double x,
                                 double reach) {
    const int n = level->cells[axis];
    const double at = (x - w->cell_origin[axis])/level->size[axis], far = reach/level->size[axis];
    demi_stretch s;
    s.round = 0;
    if (w->desc.boundary[axis] != DEM_BOUNDARY_PERIODIC) {
        s.first = (int)DEMI_MIN(DEMI_MAX(at - far, 0), n - 1);
        s.last = (int)DEMI_MIN(DEMI_MAX(at + far, 0), n - 1);
        return s;
    }
    s.round = 2*far + 2 >= n;
    s.first = s.round ? 0 : (int)(at - far + n) - n;       /* rounds down: at - far > -n */
    s.last = s.round ? n - 1 : (int)(at + far);
    return s;
}
/* Squared distance, m2, of x from cell c along one axis. */
DEM_INLINE double demi_level_gap2(const dem_world *w, const demi_level *level, int axis, double x,
                                  int c) {
    const double from = w->cell_origin[axis] + level->size[axis]*c - x;
    const double to = from + level->size[axis], gap = from > 0 ? from : to < 0 ? to : 0;
    return gap*gap;
}
/* Tests body a with the bodies of higher index in cells `first` to `last` of a row along x. */
static void demi_level_offer(dem_world *w, int d, const demi_periods *p, int a, int row,
                             int first, int last) {
    const int32_t *start = w->cell_start;
    const int end = start[row + last + 1];
    int i;
    for (i = start[row + first]; i < end; i++)
        if (w->bodies.order[i] > a)
            demi_pair_offer(w, d, p, demi_cover(w), a, w->bodies.order[i]);
}
/* Tests body a with the bodies of one level that are within reach. */
static void demi_row_level(dem_world *w, int d, const demi_periods *p, int a,
                           const demi_level *level) {
    const dem_real *at = w->bodies.pos + 4*a;
    const double x = demi_upright(p, at), y = (double)at[1], z = (double)at[2];
    const int *n = level->cells;
    /* bound on the rounding error of distances over a whole period */
    const double slack = (DEMI_SINGLE ? 4e-7 : 1e-14)*(w->cell_size[0]*w->cells[0] +
        w->cell_size[1]*w->cells[1] + w->cell_size[2]*w->cells[2]);
    const double reach =
        ((double)demi_radius(w, a) + level->radius + (double)demi_cover(w))*(1 + 1e-5) + slack;
    const double slant = demi_slant(p), lean = (slant - 1)*reach;
    const demi_stretch sx = demi_level_span(w, level, 0, x, reach*slant);
    const demi_stretch sy = demi_level_span(w, level, 1, y, reach);
    const demi_stretch sz = demi_level_span(w, level, 2, z, reach);
    int j, k;
    for (k = sz.first; k <= sz.last; k++) {
        const double left = reach*reach - (sz.round ? 0 : demi_level_gap2(w, level, 2, z, k));
        const int slice = level->first + n[0]*n[1]*(k < 0 ? k + n[2] : k >= n[2] ? k - n[2] : k);
        for (j = sy.first; j <= sy.last; j++) {
            const double still = left - (sy.round ? 0 : demi_level_gap2(w, level, 1, y, j));
            const int row = slice + n[0]*(j < 0 ? j + n[1] : j >= n[1] ? j - n[1] : j);
            demi_stretch s = sx;
            if (still < 0) continue;
            /* clips the row to the sphere of reach, which is shorter than the cube's edge */
            if (s.last - s.first > 3 && !s.round)
                s = demi_level_span(w, level, 0, x, sqrt(still) + lean);
            if (s.first < 0) {
                demi_level_offer(w, d, p, a, row, s.first + n[0], n[0] - 1);
                s.first = 0;
            }
            if (s.last >= n[0]) {
                demi_level_offer(w, d, p, a, row, 0, s.last - n[0]);
                s.last = n[0] - 1;
            }
            demi_level_offer(w, d, p, a, row, s.first, s.last);
        }
    }
}

/* Restores the heap order of v[0] .. v[n - 1] below index `at`. */
static void demi_heap_sink(int32_t *v, int at, int n) {
    const int32_t t = v[at];
    int child;
    for (; (child = 2*at + 1) < n; at = child) {
        if (child + 1 < n && v[child + 1] > v[child]) child++;
        if (v[child] <= t) break;
        v[at] = v[child];
    }
    v[at] = t;
}
/* Sorts n integers: few by insertion, many by heap sort. It needs no memory and no recursion, and
   has no bad case. */
static void demi_ints_sort(int32_t *v, int n) {
    int i, j;
    if (n <= 32) {
        for (i = 1; i < n; i++) {
            const int32_t t = v[i];
            for (j = i; j > 0 && v[j - 1] > t; j--) v[j] = v[j - 1];
            v[j] = t;
        }
        return;
    }
    for (i = n/2 - 1; i >= 0; i--) demi_heap_sink(v, i, n);
    for (i = n - 1; i > 0; i--) {
        const int32_t t = v[0];
        v[0] = v[i];
        v[i] = t;
        demi_heap_sink(v, 0, i);
    }
}
/* Sorts the partners of one body, entries `from` to `to` - 1 of the group. Partner and image are
   packed into one integer: there are fewer than INT_MAX/64 bodies and 27 images, whose offsets are
   multiples of 4. */
static void demi_row_sort(const demi_list *list, int d, int from, int to) {
    int32_t *b = list->b + d*list->stride;
    unsigned char *image = list->image + d*list->stride;
    int k;
    for (k = from + 1; k < to && b[k - 1] < b[k]; k++) {}
    if (k >= to) return;
    for (k = from; k < to; k++) b[k] = 32*b[k] + image[k]/4;
    demi_ints_sort(b + from, to - from);
    for (k = from; k < to; k++) {
        image[k] = (unsigned char)(b[k]%32*4);
        b[k] /= 32;
    }
}
/* Searches all levels for each body, then sorts its partners, which gives the order of one grid. */
static void demi_rows_levels(dem_world *w, int d) {
    const demi_periods p = demi_periods_of(w);
    const demi_domain *domain = &w->domains[d];
    int a, l;
    for (a = domain->begin; a < domain->end; a++) {
        const int own = domain->own, cross = domain->cross;
        for (l = 0; l < w->levels.count; l++) demi_row_level(w, d, &p, a, &w->levels.level[l]);
        demi_row_sort(&w->own, d, own, domain->own);
        demi_row_sort(&w->cross, d, cross, domain->cross);
    }
}

/* --- linked linear list [ALK07] 2.3.2, a sweep and prune. On each axis the ends of all bounding
       boxes are kept in one sorted list. After bodies have moved, insertion sort restores the order
       by exchanges of neighbours. When the lower end of one box passes the upper end of another,
       the two start or cease to overlap on that axis, and the pair table is updated. Boxes have
       half width radius + skin/2. On a periodic axis every box counts as infinite, which is correct
       but slow. --- */
typedef struct demi_pair_key { int32_t lo, hi; } demi_pair_key;          /* slots; lo = -1: empty */

/* Hash of a pair in a table of `room` entries, a power of two. */
static size_t demi_pair_hash(int32_t lo, int32_t hi, size_t room) {
    uint64_t x = ((uint64_t)(uint32_t)lo << 32 | (uint32_t)hi)*UINT64_C(0x9E3779B97F4A7C15);
    return (size_t)(x >> 20) & (room - 1);
}
/* Adds a pair to the table unless it is there: open addressing in a power of two of entries, at
   most two thirds full. Returns 0 if memory runs out. */
static int demi_pair_table_add(dem_world *w, int32_t a, int32_t b) {
    demi_pair_key *table = w->lll_table;
    size_t room = demi_room(table, sizeof *table), k;
    const int32_t lo = DEMI_MIN(a, b), hi = DEMI_MAX(a, b);
    if (3*(size_t)(w->lll_size + 1) > 2*room) {
        const size_t fresh_room = room ? 2*room : 1024;
        demi_pair_key *fresh = (demi_pair_key *)demi_hold(w, DEMI_RUN, fresh_room, sizeof *fresh);
        size_t i;
        if (!fresh) return 0;
        for (i = 0; i < fresh_room; i++) fresh[i].lo = -1;
        for (i = 0; i < room; i++) {
            if (table[i].lo < 0) continue;
            k = demi_pair_hash(table[i].lo, table[i].hi, fresh_room);
            while (fresh[k].lo >= 0) k = (k + 1) & (fresh_room - 1);
            fresh[k] = table[i];
        }
        demi_free(w, table);
        w->lll_table = table = fresh;
        room = fresh_room;
    }
    for (k = demi_pair_hash(lo, hi, room); table[k].lo >= 0; k = (k + 1) & (room - 1))
        if (table[k].lo == lo && table[k].hi == hi) return 1;
    table[k].lo = lo;
    table[k].hi = hi;
    w->lll_size++;
    return 1;
}
/* Removes a pair if it is there. No tombstones: later entries move up, so that no search stops at a
   gap [Knuth, 6.4, algorithm R]. */
static void demi_pair_table_remove(dem_world *w, int32_t a, int32_t b) {
    demi_pair_key *table = w->lll_table;
    const size_t room = demi_room(table, sizeof *table);
    const int32_t lo = DEMI_MIN(a, b), hi = DEMI_MAX(a, b);
    size_t k, gap;
    if (!room) return;
    for (k = demi_pair_hash(lo, hi, room); table[k].lo != lo || table[k].hi != hi;
         k = (k + 1) & (room - 1))
        if (table[k].lo < 0) return;
    w->lll_size--;
    for (gap = k;;) {
        size_t home;
        table[gap].lo = -1;
        do {
            k = (k + 1) & (room - 1);
            if (table[k].lo < 0) return;
            home = demi_pair_hash(table[k].lo, table[k].hi, room);
        } while (gap <= k ? gap < home && home <= k : gap < home || home <= k);
        table[gap] = table[k];
        gap = k;
    }
}
/* Lower or upper end, m, of the box of a body, by slot. */
static dem_real demi_box_end(const dem_world *w, int slot, int axis, int upper) {
    const int i = w->bodies.slot_index[slot];
    const dem_real grow = demi_radius(w, i) + demi_cover(w)/2;
    return upper ? w->bodies.pos[4*i + axis] + grow : w->bodies.pos[4*i + axis] - grow;
}
/* True if the boxes of two bodies, by slot, overlap on every axis that is not periodic. */
static int demi_boxes_overlap(const dem_world *w, int s, int t) {
    int k;
    for (k = 0; k < 3; k++) {
        if (w->desc.boundary[k] == DEM_BOUNDARY_PERIODIC) continue;
        if (demi_box_end(w, s, k, 1) < demi_box_end(w, t, k, 0)) return 0;
        if (demi_box_end(w, t, k, 1) < demi_box_end(w, s, k, 0)) return 0;
    }
    return 1;
}
/* Order of the ends: by value, then lower before upper ends, then by slot. */
static int demi_end_before(const demi_end *x, const demi_end *y) {
    if (x->value < y->value) return 1;
    if (x->value > y->value) return 0;
    if (x->upper != y->upper) return x->upper < y->upper;
    return x->box < y->box;
}
static int demi_end_compare(const void *x, const void *y) {
    return demi_end_before((const demi_end *)x, (const demi_end *)y) ? -1 : 1;
}
/* Builds the lists and the pair table from scratch, at the first search and after bodies were added
   or removed: sorts the ends and sweeps the first axis that is not periodic. Returns 0 if memory
   runs out. */
static int demi_lll_start(dem_world *w) {
    const int n = w->bodies.count;
    size_t i;
    int axis, k, j, open = 0, sweep = 0;
    int32_t *active;
    demi_end *ends;
    for (axis = 0; axis < 3; axis++) {
        if (!DEMI_GROW(w, w->lll_ends[axis], (size_t)n*2)) return 0;
        ends = w->lll_ends[axis];
        for (k = 0; k < 2*n; k++) {
            ends[k].box = (int32_t)w->bodies.slot[k/2];
            ends[k].upper = k & 1;
            ends[k].value = demi_box_end(w, ends[k].box, axis, k & 1);
        }
        if (n) qsort(ends, (size_t)n*2, sizeof *ends, demi_end_compare);
    }
    for (i = 0; i < demi_room(w->lll_table, sizeof *w->lll_table); i++) w->lll_table[i].lo = -1;
    w->lll_size = 0;
    w->lll_boxes = n;
    while (sweep < 3 && w->desc.boundary[sweep] == DEM_BOUNDARY_PERIODIC) sweep++;
    if (sweep == 3) {                           /* all axes periodic: every pair */
        for (k = 0; k < n; k++)
            for (j = k + 1; j < n; j++)
                if (!demi_pair_table_add(w, (int32_t)w->bodies.slot[k],
                                         (int32_t)w->bodies.slot[j])) return 0;
        return 1;
    }
    if (!DEMI_GROW(w, w->lll_rows, (size_t)n)) return 0;
    active = w->lll_rows;
    ends = w->lll_ends[sweep];
    for (k = 0; k < 2*n; k++) {
        if (ends[k].upper) {
            for (j = 0; active[j] != ends[k].box; j++) {}
            active[j] = active[--open];
            continue;
        }
        for (j = 0; j < open; j++)
            if (demi_boxes_overlap(w, active[j], ends[k].box) &&
                !demi_pair_table_add(w, active[j], ends[k].box)) return 0;
        active[open++] = ends[k].box;
    }
    return 1;
}
/* Updates the lists by insertion sort and the pair table at each exchange. Returns 0 if memory runs
   out. */
static int demi_lll_update(dem_world *w) {
    int axis, k, j;
    for (axis = 0; axis < 3; axis++) {
        demi_end *ends = w->lll_ends[axis];
        for (k = 0; k < 2*w->lll_boxes; k++)
            ends[k].value = demi_box_end(w, ends[k].box, axis, ends[k].upper);
        for (k = 1; k < 2*w->lll_boxes; k++) {
            const demi_end e = ends[k];
            for (j = k; j > 0 && demi_end_before(&e, &ends[j - 1]); j--) {
                const demi_end *f = &ends[j - 1];
                if (e.upper != f->upper && e.box != f->box &&
                    w->desc.boundary[axis] != DEM_BOUNDARY_PERIODIC) {
                    /* upper end passes lower end: the boxes separate */
                    if (e.upper) demi_pair_table_remove(w, e.box, f->box);
                    /* lower end passes upper end */
                    else if (demi_boxes_overlap(w, e.box, f->box) &&
                             !demi_pair_table_add(w, e.box, f->box)) return 0;
                }
                ends[j] = ends[j - 1];
            }
            ends[j] = e;
        }
    }
    return 1;
}
static int demi_int_compare(const void *x, const void *y) {
    const int32_t a = *(const int32_t *)x, b = *(const int32_t *)y;
    return a < b ? -1 : a > b;
}
/* Updates the pair table and lists its pairs by their lower body, partners ascending. Returns 0 if
   memory runs out. */
static int demi_lll_rows(dem_world *w) {
    int32_t *start, *rows;
    size_t i;
    int k, pass, fresh;
    fresh = !w->lll_valid;
    w->lll_valid = 0;                           /* until it is complete */
    if (fresh ? !demi_lll_start(w) : !demi_lll_update(w)) return 0;
    w->lll_valid = 1;
    if (!DEMI_GROW(w, w->lll_row_start, (size_t)w->bodies.count + 2) ||
        !DEMI_GROW(w, w->lll_rows, (size_t)w->lll_size)) return 0;
    start = w->lll_row_start;
    rows = w->lll_rows;
    memset(start, 0, ((size_t)w->bodies.count + 2)*sizeof(int32_t));
    for (pass = 0; pass < 2; pass++) {
        for (i = 0; i < demi_room(w->lll_table, sizeof *w->lll_table); i++) {
            const demi_pair_key *key = w->lll_table + i;
            int a, b;
            if (key->lo < 0) continue;
            a = w->bodies.slot_index[key->lo];
            b = w->bodies.slot_index[key->hi];
            if (pass == 0) start[DEMI_MIN(a, b) + 2]++;
            else rows[start[DEMI_MIN(a, b) + 1]++] = DEMI_MAX(a, b);
        }
        if (pass == 0) for (k = 2; k < w->bodies.count + 2; k++) start[k] += start[k - 1];
    }
    for (k = 0; k < w->bodies.count; k++)
        if (start[k + 1] > start[k])
            qsort(rows + start[k], (size_t)(start[k + 1] - start[k]), sizeof *rows,
                  demi_int_compare);
    return 1;
}
/* Tests the pairs that demi_lll_rows has listed. */
static void demi_rows_linked(dem_world *w, int d) {
    const demi_periods p = demi_periods_of(w);
    const int32_t *start = w->lll_row_start;
    const int32_t *rows = w->lll_rows;
    int a, k;
    for (a = w->domains[d].begin; a < w->domains[d].end; a++)
        for (k = start[a]; k < start[a + 1]; k++)
            demi_pair_offer(w, d, &p, demi_cover(w), a, rows[k]);
}

/* --- bins of bounding boxes [MAZ11]: each body is entered in every bin that its box (half width
       radius + skin/2) touches, so bodies need not be smaller than a bin. A pair is found only in
       the first bin of a that b also touches, on every axis. Periodic axes wrap. --- */

/* Computes the bins of a body's box: for each axis the first one and how many more. */
static void demi_bins_of(dem_world *w, int body) {
    const double grow = ((double)demi_radius(w, body) + (double)demi_cover(w)/2)*(1 + 1e-5);
    const demi_periods p = demi_periods_of(w);
    const dem_real *place = w->bodies.pos + 4*body;
    int32_t *at = w->bin_of + 6*body;
    int k;
    for (k = 0; k < 3; k++) {
        const int n = w->bins[k], round = w->desc.boundary[k] == DEM_BOUNDARY_PERIODIC;
        const double x = (k ? (double)place[k] : demi_upright(&p, place)) - w->cell_origin[k];
        const double far = k ? grow : grow*demi_slant(&p);
        const double lo = floor((x - far)/w->bin_size[k]), hi = floor((x + far)/w->bin_size[k]);
        if (round && hi - lo + 1 >= n) { at[2*k] = 0; at[2*k + 1] = n - 1; continue; }
        at[2*k] = (int32_t)(round ? lo - n*floor(lo/n) : DEMI_MAX(DEMI_MIN(lo, n - 1), 0));
        at[2*k + 1] = (int32_t)(round ? hi - lo : DEMI_MAX(DEMI_MIN(hi, n - 1), 0) - at[2*k]);
    }
}
/* Counts a body in its bins if items is null, otherwise enters it. */
static void demi_bins_deal(const dem_world *w, int body, int32_t *count, int32_t *items) {
    const int32_t *at = w->bin_of + 6*body;
    const int *n = w->bins;
    int i, j, k;
    for (k = 0; k <= at[5]; k++)
        for (j = 0; j <= at[3]; j++)
            for (i = 0; i <= at[1]; i++) {
                const int bin = (at[0] + i)%n[0] + n[0]*((at[2] + j)%n[1] +
                                                         n[1]*((at[4] + k)%n[2]));
                if (items) items[count[bin]] = body;
                count[bin]++;
            }
}
/* Sets up bins about as wide as an average box, or wider if large bodies would fill too many, and
   enters all bodies. Returns 0 if memory runs out. */
static int demi_bins_lay(dem_world *w) {
    double hi[3], least = 0, all;
    int i, k, n;
    for (k = 0; k < 3; k++) hi[k] = w->cell_origin[k] + w->cell_size[k]*w->cells[k];
    for (i = 0; i < w->bodies.count; i++) least += (double)demi_radius(w, i);
    least = 2*least/DEMI_MAX(w->bodies.count, 1) + (double)demi_cover(w) + 1e-300;
    if (!DEMI_GROW(w, w->bin_of, 6*(size_t)w->bodies.count + 6)) return 0;
    do {
        demi_cells_lay(w->cell_origin, hi, least, 1, w->bodies.count, w->bins, w->bin_size);
        for (i = 0, all = 0; i < w->bodies.count; i++) {
            const int32_t *at = w->bin_of + 6*i;
            demi_bins_of(w, i);
            all += (at[1] + 1.0)*(at[3] + 1.0)*(at[5] + 1.0);
        }
        least *= 1.5;
    } while (all > 64.0*w->bodies.count + 1e6);
    n = w->bins[0]*w->bins[1]*w->bins[2];
    if (!DEMI_GROW(w, w->bin_start, (size_t)n + 2) ||
        !DEMI_GROW(w, w->bin_items, (size_t)all + 1)) return 0;
    memset(w->bin_start, 0, ((size_t)n + 2)*sizeof(int32_t));
    for (i = 0; i < w->bodies.count; i++) demi_bins_deal(w, i, w->bin_start + 2, 0);
    for (i = 2; i < n + 2; i++) w->bin_start[i] += w->bin_start[i - 1];
    for (i = 0; i < w->bodies.count; i++) demi_bins_deal(w, i, w->bin_start + 1, w->bin_items);
    return 1;
}
/* True if the i-th bin of a, along an axis of n bins, is the first that b also touches. */
DEM_INLINE int demi_bins_meet(const int32_t *a, const int32_t *b, int i, int n) {
    const int behind = a[0] < b[0] ? a[0] - b[0] + n : a[0] - b[0];
    return i == (behind <= b[1] ? 0 : n - behind);
}
/* Tests each body with the bodies in its bins. */
static void demi_rows_bins(dem_world *w, int d) {
    const demi_periods p = demi_periods_of(w);
    const demi_domain *domain = &w->domains[d];
    const int *n = w->bins;
    int a, i, j, k, e;
    for (a = domain->begin; a < domain->end; a++) {
        const int own = domain->own, cross = domain->cross;
        const int32_t *at = w->bin_of + 6*a;
        for (k = 0; k <= at[5]; k++)
            for (j = 0; j <= at[3]; j++)
                for (i = 0; i <= at[1]; i++) {
                    const int bin = (at[0] + i)%n[0] + n[0]*((at[2] + j)%n[1] +
                                                             n[1]*((at[4] + k)%n[2]));
                    for (e = w->bin_start[bin + 1] - 1; e >= w->bin_start[bin]; e--) {
                        const int b = w->bin_items[e];
                        const int32_t *other = w->bin_of + 6*b;
                        if (b <= a) break;      /* items are ascending */
                        if (demi_bins_meet(at, other, i, n[0]) &&
                            demi_bins_meet(at + 2, other + 2, j, n[1]) &&
                            demi_bins_meet(at + 4, other + 4, k, n[2]))
                            demi_pair_offer(w, d, &p, demi_cover(w), a, b);
                    }
                }
        demi_row_sort(&w->own, d, own, domain->own);
        demi_row_sort(&w->cross, d, cross, domain->cross);
    }
}

/* --- table of the methods --- */

/* Searches by cells, of one size or of several (levels). */
static void demi_rows_cells(dem_world *w, int d) {
    if (w->levels.count) demi_rows_levels(w, d); else demi_rows_grid(w, d);
}
/* Search methods, one row each, in the order of dem_search (>>add-search). All find the same pairs.
   name: in reports. rows: finds the candidates of a work group and passes each to demi_pair_offer.
   lay: prepares a search and returns 0 if memory runs out; null: the cells of the sort suffice.
   crowds: 1 if all bodies of a cell are tested with each other, so that crowded cells are
   expensive. */
typedef struct demi_search_row {
    const char *name;
    void (*rows)(dem_world *w, int d);
    int (*lay)(dem_world *w);
    int crowds;
} demi_search_row;
static const demi_search_row demi_searches[] = {
    {"automatic", demi_rows_cells, 0, 1},       /* replaced by another at the first list */
    {"all pairs", demi_rows_all_pairs, 0, 0},
    {"uniform grid", demi_rows_cells, 0, 1},
    {"linked linear list", demi_rows_linked, demi_lll_rows, 0},
    {"hierarchical grid", demi_rows_cells, 0, 1},
    {"bins of bounding boxes", demi_rows_bins, demi_bins_lay, 0},
};
enum { DEMI_SEARCHES = (int)(sizeof demi_searches/sizeof *demi_searches) };

/* Finds the candidates of one work group by the method in force. */
static void demi_domain_search(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    domain->own = domain->cross = 0;
    domain->overflow &= ~3;
    demi_searches[w->desc.search].rows(w, d);
}
