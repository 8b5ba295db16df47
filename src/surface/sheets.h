/* ---------------------------------------------------------------------------------------------
   >>sheets
   Sheets: the connected pieces of a wall's surface, the orientation of their facets, and their
   borders. They are found when a wall is loaded. Contacts of polyhedra need them, because a surface
   acts on a polyhedron from one side only.
   --------------------------------------------------------------------------------------------- */

/* True if a side of a triangle (3*element + side) has no neighbour, or one that is too thin to
   count. beside: as in demi_wall_sheets. */
static int demi_side_ends(const demi_wall *wall, const int32_t *beside, int side) {
    const dem_vec3 n = demi_at(wall->planes + 4*(DEMI_MAX(beside[side], 0)/3));
    return beside[side] < 0 || !(demi_dot(n, n) > 0);
}
/* Finds the borders of sheets, and the mean normals of the sheet there: over all its triangles at a
   corner, weighted by their angles, which does not change if a triangle is divided. Returns 0 if
   memory ran out. */
static int demi_wall_borders(dem_world *w, demi_wall *wall, const int32_t *beside) {
    const int all = wall->element_count, points = wall->vertex_count;
    int32_t *first = (int32_t *)demi_alloc(w, (size_t)(points + 2 + 3*all), sizeof *first);
    int32_t *at = first ? first + points + 2 : 0;      /* 3*element + corner, by vertex */
    int i, k, c, count = 0;
    for (i = 0; i < 3*all; i++) count += demi_side_ends(wall, beside, i);
    wall->border_count = count;
    wall->borders = (demi_border *)demi_hold(w, wall->chain, (size_t)DEMI_MAX(count, 1),
                                             sizeof *wall->borders);
    if (!first || !wall->borders) { demi_free(w, first); return 0; }
    memset(first, 0, (size_t)(points + 2)*sizeof *first);
    for (i = 0; i < 3*all; i++) first[wall->corners[i] + 2]++;
    for (i = 2; i < points + 2; i++) first[i] += first[i - 1];
    for (i = 0; i < 3*all; i++) at[first[wall->corners[i] + 1]++] = i;
    for (i = 0, count = 0; i < 3*all; i++) {
        demi_border *e = &wall->borders[count];
        if (!demi_side_ends(wall, beside, i)) continue;
        count++;
        e->side = i;
        for (k = 0; k < 2; k++) {
            const int32_t v = wall->corners[i/3*3 + (i + k)%3];
            e->normal[k] = demi_v(0, 0, 0);
            for (c = first[v]; c < first[v + 1]; c++) {
                const int32_t *own = wall->corners + at[c]/3*3, sheet = wall->sheet[at[c]/3];
                const dem_vec3 x = demi_at(wall->vertices + 3*v);
                const dem_vec3 p = demi_sub(demi_at(wall->vertices + 3*own[(at[c] + 1)%3]), x);
                const dem_vec3 q = demi_sub(demi_at(wall->vertices + 3*own[(at[c] + 2)%3]), x);
                const double angle = demi_atan2((double)demi_length(demi_cross(p, q)),
                                                (double)demi_dot(p, q));
                if (sheet != wall->sheet[i/3] && sheet != -wall->sheet[i/3]) continue;
                e->normal[k] = demi_add(e->normal[k], demi_scale(
                    demi_at(wall->planes + 4*(at[c]/3)), (dem_real)(sheet < 0 ? -angle : angle)));
            }
            if (demi_dot(e->normal[k], e->normal[k]) > 0) e->normal[k] = demi_unit(e->normal[k]);
        }
    }
    demi_free(w, first);
    return 1;
}
/* Assigns facets to sheets: those connected by edges (for segments: ends) that exactly two facets
   share. wall->sheet is negative for facets that are oriented opposite to the first of their sheet.
   beside: for each side the neighbour's (3*element + side), or -1. Returns 0 if memory ran
   out. */
static int demi_wall_sheets(dem_world *w, demi_wall *wall) {
    const int n = demi_wall_per(wall), all = wall->element_count;
    demi_side *sides = (demi_side *)demi_alloc(w, (size_t)all*3, sizeof *sides);
    int32_t *beside = (int32_t *)demi_alloc(w, (size_t)all*4, sizeof *beside);
    int32_t *row = beside ? beside + 3*all : 0;
    int i, k, count = 0, rows, sheets = 0;
    wall->sheet = (int32_t *)demi_hold(w, wall->chain, (size_t)all, sizeof(int32_t));
    for (i = 0; i < all && sides && beside && wall->sheet; i++)
        for (k = 0; k < n; k++) {
            const int32_t *c = wall->corners + n*i;
            sides[count++] = demi_side_of(c[k], n == 3 ? c[(k + 1)%3] : c[k], i, k);
        }
    if (count) qsort(sides, (size_t)count, sizeof *sides, demi_side_compare);
    for (i = 0; i < 3*all && beside; i++) beside[i] = -1;
    for (i = 0; i < count; i = k) {
        for (k = i + 1; k < count && sides[k].lo == sides[i].lo && sides[k].hi == sides[i].hi; k++)
            continue;
        if (k != i + 2) continue;
        beside[3*sides[i].facet + sides[i].side] = 3*sides[i + 1].facet + sides[i + 1].side;
        beside[3*sides[i + 1].facet + sides[i + 1].side] = 3*sides[i].facet + sides[i].side;
    }
    for (i = 0; i < all && count; i++) {
        if (wall->sheet[i]) continue;
        wall->sheet[i] = ++sheets;
        row[0] = i;
        for (rows = 1; rows > 0;) {
            const int from = row[--rows];
            for (k = 0; k < n; k++) {
                const int32_t other = beside[3*from + k];
                int32_t *sheet;
                int same;
                if (other < 0 || wall->sheet[other/3]) continue;
                sheet = &wall->sheet[other/3];
                /* same orientation: the edge runs in opposite directions, or one ends where the
                   other begins */
                same = n == 2 ? other%3 != k
                    : wall->corners[3*from + k] != wall->corners[3*(other/3) + other%3];
                *sheet = same ? wall->sheet[from] : -wall->sheet[from];
                row[rows++] = other/3;
            }
        }
    }
    demi_free(w, sides);
    i = count && (n != 3 || demi_wall_borders(w, wall, beside));
    demi_free(w, beside);
    return i;
}
