/* ---------------------------------------------------------------------------------------------
   >>closed
   Orientation of closed meshes: finds which side of a mesh is inside. Vertices at the same position
   are one vertex, and of equal triangles at most one counts. Two triangles that share an edge with
   no third must run along it in opposite directions. This fixes the orientation of every triangle
   of a shell (the triangles that such edges join) relative to its first, whatever their order of
   corners. A body is bounded by shells without open edges. An outer shell faces out. A shell within
   a shell is a cavity if it was written to face the opposite way of the shell around it; otherwise
   the mesh is rejected with an error message. Works on a demi_closed; changes neither the world nor
   the mesh. Tests: tests/file/test_decompose.c.
   --------------------------------------------------------------------------------------------- */
/* Largest number of shells; corners that are tested for being inside another shell. */
enum { DEMI_CLOSED_SHELLS = 1000, DEMI_CLOSED_LOOKS = 20 };
/* The analysis of a mesh. */
typedef struct demi_closed {
    const dem_mesh *mesh;
    int32_t *corner;               /* triangles x 3: the first vertex at that position */
    int32_t *edge;                 /* triangles x 3: the first triangle side that is this edge */
    int32_t *parent;               /* of a triangle: the next one towards the root of its shell */
    unsigned char *turned;         /* 1: it faces the other way than its parent */
    signed char *sign;             /* 1; -1: its corners must be reversed; 0: does not count */
    /* edges with one triangle, with more than two; duplicate triangles; reversed triangles; edges
       of a one-sided shell; shells */
    int open, crowded, duplicates, flipped, twisted, shells;
} demi_closed;

/* Returns for each key of `width` bytes the index of the first equal key: count int32, which the
   caller frees; null if memory ran out. Hashing with open addressing, table at most half full. */
static int32_t *demi_first_equal(dem_world *w, const void *keys, size_t count, size_t width) {
    const char *key = (const char *)keys;
    size_t i, slots = 16;
    int32_t *first, *table; /* table: index + 1, or 0 */
    while (slots < 2*count) slots *= 2;
    first = (int32_t *)demi_alloc(w, count, sizeof(int32_t));
    table = (int32_t *)demi_alloc(w, slots, sizeof(int32_t));
    for (i = 0; first && table && i < count; i++) {
        const char *mine = key + i*width;
        size_t at = (size_t)demi_hash(DEMI_HASH_START, mine, width) & (slots - 1);
        while (table[at] && memcmp(key + (size_t)(table[at] - 1)*width, mine, width) != 0)
            at = (at + 1) & (slots - 1);
        if (!table[at]) table[at] = (int32_t)i + 1;
        first[i] = table[at] - 1;
    }
    demi_free(w, table);
    if (!table) demi_free(w, first);
    return table ? first : 0;
}
static void demi_closed_free(dem_world *w, demi_closed *c) {
    demi_free(w, c->corner);
    demi_free(w, c->edge);
    demi_free(w, c->parent);
    demi_free(w, c->turned);
    demi_free(w, c->sign);
}
/* Returns the triangle that represents the shell of triangle i (union-find). *turned is 1 if
   triangle i faces the other way than that. */
static int demi_closed_shell(demi_closed *c, int i, int *turned) {
    for (*turned = 0; c->parent[i] != i; i = c->parent[i]) {
        const int up = c->parent[i];
        c->parent[i] = c->parent[up];
        c->turned[i] ^= c->turned[up];
        *turned ^= c->turned[i];
    }
    return i;
}
/* Returns 1 if a triangle side runs from the lower to the higher vertex, otherwise -1. */
static int demi_closed_way(const demi_closed *c, size_t side) {
    return c->corner[side] < c->corner[side - side%3 + (side + 1)%3] ? 1 : -1;
}
/* Unites vertices at the same position; -0 is equal to 0. Returns 0 if memory ran out. */
static int demi_closed_weld(dem_world *w, demi_closed *c) {
    const size_t n = (size_t)c->mesh->vertex_count;
    dem_real *place = (dem_real *)demi_alloc(w, 3*n, sizeof *place);
    int32_t *first = 0;
    size_t i;
    for (i = 0; place && i < 3*n; i++) place[i] = c->mesh->vertices[i] + 0;
    if (place) first = demi_first_equal(w, place, n, 3*sizeof *place);
    for (i = 0; first && i < 3*(size_t)c->mesh->triangle_count; i++)
        c->corner[i] = first[c->mesh->triangles[i]];
    demi_free(w, place);
    demi_free(w, first);
    return first != 0;
}
/* Lets one of several triangles with the same corners count: one that faces the way of the
   majority. None counts if equally many face each way (an inner wall), nor does a triangle that has
   a corner twice. Returns 0 if memory ran out. */
static int demi_closed_equals(dem_world *w, demi_closed *c) {
    const int n = c->mesh->triangle_count;
    int32_t *key = (int32_t *)demi_alloc(w, 3*(size_t)n, sizeof *key), *first = 0, *most;
    int i;
    for (i = 0; key && i < n; i++) {
        int32_t *k = key + 3*i, a = c->corner[3*i], b = c->corner[3*i + 1], d = c->corner[3*i + 2];
        k[0] = DEMI_MIN(a, DEMI_MIN(b, d));
        k[2] = DEMI_MAX(a, DEMI_MAX(b, d));
        k[1] = DEMI_MAX(DEMI_MIN(a, b), DEMI_MIN(DEMI_MAX(a, b), d));
        c->sign[i] = (signed char)(a == b || b == d || d == a ? 0 :
                                   (a < b) + (b < d) + (d < a) == 2 ? 1 : -1);
    }
    if (key) first = demi_first_equal(w, key, (size_t)n, 3*sizeof *key);
    most = key;                                 /* keys are no longer needed: reuse the memory */
    if (first) memset(most, 0, (size_t)n*sizeof *most);
    for (i = 0; first && i < n; i++) {
        most[first[i]] += c->sign[i];
        c->duplicates += first[i] != i;
    }
    for (i = 0; first && i < n; i++) {
        const int32_t sum = most[first[i]];
        if (c->sign[i]*sum <= 0) { c->sign[i] = 0; continue; }
        most[first[i]] = 0;                     /* the others do not count */
        c->sign[i] = 1;
    }
    demi_free(w, key);
    demi_free(w, first);
    return first != 0;
}
/* Counts the triangles at each edge, and joins triangles into shells across edges that have two.
   Returns 0 if memory ran out. */
static int demi_closed_join(dem_world *w, demi_closed *c) {
    const size_t sides = 3*(size_t)c->mesh->triangle_count;
    int32_t *key = (int32_t *)demi_alloc(w, 2*sides, sizeof *key), *all = key, *live;
    size_t i;
    for (i = 0; key && i < sides; i++) {        /* a triangle with a corner twice has no edges */
        const int32_t *t = c->corner + i/3*3, a = t[i%3], b = t[(i + 1)%3];
        const int none = t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
        key[2*i] = none ? -1 : DEMI_MIN(a, b);
        key[2*i + 1] = none ? -1 : DEMI_MAX(a, b);
    }
    c->edge = key ? demi_first_equal(w, key, sides, 2*sizeof *key) : 0;
    if (!c->edge) { demi_free(w, key); return 0; }
    for (i = 0; i < sides; i++) if (key[2*i] < 0) c->edge[i] = -1;
    memset(key, 0, 2*sides*sizeof *key);        /* from here on: triangles at each edge */
    live = key + sides;
    for (i = 0; i < sides; i++) {
        if (c->edge[i] < 0) continue;
        all[c->edge[i]]++;
        live[c->edge[i]] += c->sign[i/3] != 0;
    }
    for (i = 0; i < sides; i++) {
        c->open += all[i] == 1;
        c->crowded += all[i] > 2;
        all[i] = -1;                            /* from here on: the first of the two */
    }
    for (i = 0; i < sides; i++) {
        int32_t *other = all + DEMI_MAX(c->edge[i], 0);
        int turned, its, a, b;
        if (c->edge[i] < 0 || !c->sign[i/3] || live[c->edge[i]] != 2) continue;
        if (*other < 0) { *other = (int32_t)i; continue; }
        a = demi_closed_shell(c, (int)(i/3), &turned);
        b = demi_closed_shell(c, *other/3, &its);
        turned ^= its ^ (demi_closed_way(c, i) == demi_closed_way(c, (size_t)*other));
        if (a == b) { c->twisted += turned; continue; }
        c->parent[a] = b;
        c->turned[a] = (unsigned char)turned;
    }
    demi_free(w, key);
    return 1;
}
/* Analyses a mesh: finds its shells and defects. Returns 0 if memory ran out; the caller must call
   demi_closed_free in any case. */
static int demi_closed_find(dem_world *w, const dem_mesh *mesh, demi_closed *c) {
    const int n = mesh->triangle_count;
    int32_t *turned;
    int i, t;
    memset(c, 0, sizeof *c);
    c->mesh = mesh;
    c->corner = (int32_t *)demi_alloc(w, 3*(size_t)n, sizeof *c->corner);
    c->parent = (int32_t *)demi_alloc(w, (size_t)n, sizeof *c->parent);
    c->turned = (unsigned char *)demi_alloc(w, (size_t)n, 1);
    c->sign = (signed char *)demi_alloc(w, (size_t)n, 1);
    if (!c->corner || !c->parent || !c->turned || !c->sign) return 0;
    for (i = 0; i < n; i++) c->parent[i] = i;
    if (!demi_closed_weld(w, c) || !demi_closed_equals(w, c) || !demi_closed_join(w, c)) return 0;
    turned = (int32_t *)demi_alloc(w, 2*(size_t)n, sizeof *turned);    /* of each shell; and all */
    if (!turned) return 0;
    for (i = 0; i < n; i++) {
        const int shell = demi_closed_shell(c, i, &t);
        turned[2*shell] += t;
        turned[2*shell + 1] += c->sign[i] != 0;
    }
    for (i = 0; i < n; i++) {
        const int shell = demi_closed_shell(c, i, &t);
        if (!c->sign[i]) continue;
        t ^= 2*turned[2*shell] > turned[2*shell + 1];   /* the majority keeps its orientation */
        c->flipped += t;
        c->sign[i] = (signed char)(t ? -1 : 1);
        c->shells += shell == i;
    }
    demi_free(w, turned);
    return 1;
}
static demi_d3 demi_mesh_corner(const dem_mesh *mesh, int triangle, int k) {
    return demi_d3_of(demi_at(mesh->vertices + 3*mesh->triangles[3*triangle + k]));
}
static void demi_mesh_triangle(const dem_mesh *mesh, int triangle, demi_d3 *corner) {
    int k;
    for (k = 0; k < 3; k++) corner[k] = demi_mesh_corner(mesh, triangle, k);
}
/* The shells that bound a body. Volumes are positive for shells that face out. */
typedef struct demi_shells {
    int count;
    int32_t *order, *start;        /* triangles by shell; count + 1 */
    double *volume;                /* m3, as written */
    demi_d3 *box;                  /* m: lowest and highest coordinates of each */
    int32_t *around, *depth;       /* the innermost shell around it, -1: none; how many are */
} demi_shells;
static void demi_shells_free(dem_world *w, demi_shells *s) {
    demi_free(w, s->order);
    demi_free(w, s->start);
    demi_free(w, s->volume);
    demi_free(w, s->box);
    demi_free(w, s->around);
    demi_free(w, s->depth);
}
/* Returns the number of edges at which the triangles of a shell do not pair up, and the first such
   side; -1 if memory ran out. */
static int demi_closed_loose(dem_world *w, demi_closed *c, int *first_side) {
    const size_t sides = 3*(size_t)c->mesh->triangle_count;
    int32_t *key = (int32_t *)demi_alloc(w, 2*sides, sizeof *key), *first = 0;
    int loose = 0, turned;
    size_t i;
    for (i = 0; key && i < sides; i++) {
        key[2*i] = c->edge[i];
        key[2*i + 1] = demi_closed_shell(c, (int)(i/3), &turned);
    }
    if (key) first = demi_first_equal(w, key, sides, 2*sizeof *key);
    if (first) memset(key, 0, sides*sizeof *key);
    for (i = 0; first && i < sides; i++)
        if (c->edge[i] >= 0) key[first[i]] += c->sign[i/3]*demi_closed_way(c, i);
    for (i = sides; first && i-- > 0;)
        if (key[i]) { loose++; *first_side = (int)i; }
    demi_free(w, key);
    demi_free(w, first);
    return first ? loose : -1;
}
/* Sorts triangles by shell, and computes volumes and boxes. Returns 0 if memory ran out. */
static int demi_shells_make(dem_world *w, demi_closed *c, demi_shells *s) {
    const int n = c->mesh->triangle_count;
    int32_t *number = (int32_t *)demi_alloc(w, (size_t)n, sizeof *number);
    int i, k, e, turned;
    s->count = c->shells;
    s->order = (int32_t *)demi_alloc(w, (size_t)n, sizeof *s->order);
    s->start = (int32_t *)demi_alloc(w, (size_t)c->shells + 2, sizeof *s->start);
    s->volume = (double *)demi_alloc(w, (size_t)c->shells + 1, sizeof *s->volume);
    s->box = (demi_d3 *)demi_alloc(w, 2*((size_t)c->shells + 1), sizeof *s->box);
    s->around = (int32_t *)demi_alloc(w, (size_t)c->shells + 1, sizeof *s->around);
    s->depth = (int32_t *)demi_alloc(w, (size_t)c->shells + 1, sizeof *s->depth);
    if (!number || !s->order || !s->start || !s->volume || !s->box || !s->around || !s->depth) {
        demi_free(w, number);
        return 0;
    }
    for (k = 0; k < 2*s->count; k++) {
        const double far = k & 1 ? -1e300 : 1e300;
        s->box[k] = demi_d(far, far, far);
    }
    for (i = k = 0; i < n; i++)
        if (c->sign[i] && demi_closed_shell(c, i, &turned) == i) number[i] = k++;
    for (i = 0; i < n; i++)
        if (c->sign[i]) s->start[number[demi_closed_shell(c, i, &turned)] + 2]++;
    for (k = 2; k <= s->count; k++) s->start[k] += s->start[k - 1];
    for (i = 0; i < n; i++) {
        demi_d3 x[3], o;
        if (!c->sign[i]) continue;
        k = number[demi_closed_shell(c, i, &turned)];
        s->order[s->start[k + 1]++] = i;
        o = demi_mesh_corner(c->mesh, demi_closed_shell(c, i, &turned), 0); /* less round-off */
        demi_mesh_triangle(c->mesh, i, x);
        for (e = 0; e < 3; e++) {
            s->box[2*k] = demi_d3_lowest(s->box[2*k], x[e]);
            s->box[2*k + 1] = demi_d3_highest(s->box[2*k + 1], x[e]);
            x[e] = demi_d3_sub(x[e], o);
        }
        s->volume[k] += c->sign[i]*demi_d3_dot(x[0], demi_d3_cross(x[1], x[2]))/6;
    }
    demi_free(w, number);
    return 1;
}
/* Returns the winding number of a shell about a point: about 0 outside, 1 or -1 inside. It is the
   sum of the solid angles of its triangles over 4 pi, each from
   tan(angle/2) = a.(b x c)/(abc + a.b c + b.c a + c.a b). */
static double demi_shells_winding(const demi_closed *c, const demi_shells *s, int shell,
                                  demi_d3 x) {
    double sum = 0;
    int i, k;
    for (i = s->start[shell]; i < s->start[shell + 1]; i++) {
        demi_d3 p[3];
        double l[3], top, bottom;
        for (k = 0; k < 3; k++) {
            p[k] = demi_d3_sub(demi_mesh_corner(c->mesh, s->order[i], k), x);
            l[k] = demi_d3_length(p[k]);
        }
        top = demi_d3_dot(p[0], demi_d3_cross(p[1], p[2]));
        bottom = l[0]*l[1]*l[2] + demi_d3_dot(p[0], p[1])*l[2] + demi_d3_dot(p[1], p[2])*l[0] +
            demi_d3_dot(p[2], p[0])*l[1];
        sum += c->sign[s->order[i]]*2*demi_atan2(top, bottom);
    }
    return sum/(4*DEMI_PI);
}
/* Returns 1 if shell a is inside shell b, 0 if not, -1 if they cross. Tests up to DEMI_CLOSED_LOOKS
   corners of a, and ignores those on the surface of b. */
static int demi_shells_inside(const demi_closed *c, const demi_shells *s, int a, int b) {
    const int n = s->start[a + 1] - s->start[a], looks = DEMI_MIN(n, (int)DEMI_CLOSED_LOOKS);
    const demi_d3 lo = demi_d3_highest(s->box[2*a], s->box[2*b]);
    const demi_d3 hi = demi_d3_lowest(s->box[2*a + 1], s->box[2*b + 1]);
    int i, in = 0, out = 0;
    if (lo.x > hi.x || lo.y > hi.y || lo.z > hi.z) return 0;
    for (i = 0; i < looks; i++) {
        const int triangle = s->order[s->start[a] + (int)((int64_t)i*n/looks)];
        const double wind = fabs(demi_shells_winding(c, s, b, demi_mesh_corner(c->mesh, triangle,
                                                                               i%3)));
        in += wind > 0.9;
        out += wind < 0.1;
    }
    return in && out ? -1 : in > 0;
}
/* Finds which shells are inside which. Returns 0 with an error message if two cross, or if one
   faces the same way as the shell around it. */
static int demi_shells_nest(dem_world *w, const char *call, const demi_closed *c, demi_shells *s) {
    demi_d3 x;
    int a, b;
    for (a = 0; a < s->count; a++)
        for (b = 0; b < s->count; b++) {
            const int in = a == b ? 0 : demi_shells_inside(c, s, a, b);
            if (in < 0) {
                x = demi_mesh_corner(c->mesh, s->order[s->start[a]], 0);
                demi_refuse(w, call, "two closed shells of the mesh cross (one begins at (%g, %g, "
                            "%g) m), must be apart or one inside the other; unite them in the "
                            "program that exported them, or pass them as separate meshes", x.x, x.y,
                            x.z);
                return 0;
            }
            s->depth[a] += in;
        }
    for (a = 0; a < s->count; a++) {
        for (s->around[a] = -1, b = 0; b < s->count && s->depth[a]; b++)
            if (b != a && s->depth[b] == s->depth[a] - 1 && demi_shells_inside(c, s, a, b) > 0)
                s->around[a] = b;
        if (s->around[a] < 0 || s->volume[a]*s->volume[s->around[a]] < 0) continue;
        x = demi_mesh_corner(c->mesh, s->order[s->start[a]], 0);
        demi_refuse(w, call, "the shell of the mesh that begins at (%g, %g, %g) m lies inside "
                    "another and faces the same way, must face the other way to be a cavity; "
                    "reverse its triangles, or leave it out if it is a second body", x.x, x.y, x.z);
        return 0;
    }
    return 1;
}
/* Gives each triangle the sign with which its normal leads out of the body: outwards on outer
   shells, into the hollow on cavities. Returns 0 with an error message if the mesh does not bound a
   body. */
static int demi_closed_body(dem_world *w, const char *call, demi_closed *c) {
    demi_shells s;
    demi_d3 x;
    int side = 0, a, i, good = 0;
    const int loose = demi_closed_loose(w, c, &side);
    if (loose < 0) { demi_no_memory(w, call); return 0; }
    x = demi_mesh_corner(c->mesh, side/3, side%3);
    if (loose || c->twisted || !c->shells || c->shells > DEMI_CLOSED_SHELLS) {
        if (c->twisted)
            demi_refuse(w, call, "the mesh is one-sided, as a Moebius strip is (no winding fits at "
                        "%d edges), so it has no inside; repair it in the program that exported it",
                        c->twisted);
        else if (loose)
            demi_refuse(w, call, "the mesh is open at %d edges, or has more than two triangles "
                        "there (first near (%.4g, %.4g, %.4g) m), so it has no inside; close it in "
                        "the program that exported it (dem_mesh_health counts such edges)", loose,
                        x.x, x.y, x.z);
        else
            demi_refuse(w, call, "the mesh has %d closed shells, must have 1 to %d; if it holds "
                        "several bodies, pass them as separate meshes", c->shells,
                        (int)DEMI_CLOSED_SHELLS);
        return 0;
    }
    memset(&s, 0, sizeof s);
    if (!demi_shells_make(w, c, &s)) demi_no_memory(w, call);
    else good = demi_shells_nest(w, call, c, &s);
    for (a = 0; a < s.count && good; a++) {
        int root = a;
        while (s.around[root] >= 0) root = s.around[root];
        for (i = s.start[a]; i < s.start[a + 1] && s.volume[root] < 0; i++)
            c->sign[s.order[i]] = (signed char)-c->sign[s.order[i]];
    }
    demi_shells_free(w, &s);
    return good;
}
