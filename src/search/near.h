/* ---------------------------------------------------------------------------------------------
   >>near
   The pruned neighbour list ("near" in names), for which forces are computed. It contains the
   candidates that touch or could touch within the time margin.span if they approached head-on at
   their present relative speed, plus margin.slack for changes of speed. Forces are computed for all
   its pairs; those that do not touch give zero. So a step neither tests candidates nor collects
   pairs. With clusters (effects.clustered) the pairs are of member spheres: those of two lone
   spheres come first, and >>members tests the others. The list is rebuilt from the candidates after
   the time margin.span, or earlier if accelerations may have used up the slack. It takes contact
   histories from the previous pruned list or, after a search, from demi_filed. Results do not
   depend on how long a list lasts, because one zero more or less does not change a sum; one
   exception: whether a sheet lies between two bodies is decided when a list is built. Proof that no
   contact is missed: let v be the relative speed of two bodies when the list is built. A step
   changes a velocity by at most last_change, that is dt times the largest acceleration of all
   bodies. After n steps the relative velocity has changed by at most 2 change, where change is the
   sum of last_change. So the two have approached by at most v t + creep, where creep is the sum
   over steps of 2 dt change. A pair that is not in the list had a gap larger than v span + slack +
   cover. As long as age < span and creep < slack, its gap is larger than cover, the range of
   contacts.
   --------------------------------------------------------------------------------------------- */

/* --- species: classes of equal spheres, and the coefficients of every two species. A scene has few
       species (beads of one or two sizes, balls and powder) or as many as grains (radii drawn at
       random), seldom a number between. With few, a pair of the pruned list stores the number of a
       row of the table: 4 bytes instead of 88 for its coefficients. Tiles whose pairs all have the
       same row copy nothing, so a single steel ball among glass beads slows only its own tiles.
       With many species, each pair stores its own coefficients. Species are determined at each
       search. A grain that a feed inserts in between must belong to one of them
       (demi_species_known), otherwise lists are rebuilt. --- */
static demi_species demi_species_of(const dem_world *w, int body, dem_real radius) {
    demi_species s;
    s.radius = radius;
    s.mass = w->bodies.mass[body];
    s.inv_mass = w->bodies.inv_mass[body];
    s.material = w->bodies.material[body];
    s.shape = demi_lone(w, body) ? 0 : w->bodies.shape[body];
    return s;
}
/* Returns the row of a species in the table, species_count if it has none. Compares every bit: a
   radius that differs in the last bit is another species. */
static int demi_species_find(const dem_world *w, const demi_species *s) {
    int k;
    for (k = 0; k < w->effects.species_count; k++)
        if (!memcmp(&w->effects.species[k], s, sizeof *s)) break;
    return k;
}
/* The species of the sphere on a side of entry `at` of the pruned list. */
static demi_species demi_near_species(const dem_world *w, size_t at, int side) {
    return demi_species_of(w, (side ? w->near.b : w->near.a)[at], demi_near_radius(w, at, side));
}
/* True if coefficients for both spheres of an entry are available. False if a checkpoint contains
   species that do not fit its bodies. */
static int demi_species_has(const dem_world *w, size_t at) {
    const demi_species one = demi_near_species(w, at, 0), other = demi_near_species(w, at, 1);
    return demi_many_species(w) || (demi_species_find(w, &one) < w->effects.species_count &&
                                    demi_species_find(w, &other) < w->effects.species_count);
}
/* Determines the species of all spheres, with springs also of those of clusters. species_count
   becomes DEMI_SPECIES + 1 if there are more than the table holds. */
static void demi_species_count(dem_world *w) {
    demi_in_force *e = &w->effects;
    int i, k;
    e->species_count = 0;
    for (i = 0; i < w->bodies.count; i++) {
        const demi_shape *shape = demi_shape_of(w, i);
        const int lone = demi_lone(w, i), count = lone ? 1 : e->clustered ? shape->count : 0;
        for (k = 0; k < count && e->species_count <= DEMI_SPECIES; k++) {
            const demi_species s = demi_species_of(w, i, lone ? demi_radius(w, i)
                : shape->parts[4*k + 3]*demi_scale_of(w, i, shape));
            if (demi_species_find(w, &s) < e->species_count) continue;
            if (e->species_count < DEMI_SPECIES) e->species[e->species_count] = s;
            e->species_count++;
        }
    }
}
/* Returns the largest inverse mass, 1/kg, with which a contact may find a body: that of a cluster
   with the smallest effective mass (demi_shape.light). Stiffnesses that depend on masses use it, as
   does the choice of the time step. */
static double demi_give_at_most(const dem_world *w, dem_real inv_mass, int shape) {
    return (double)inv_mass/(shape ? w->shapes[shape - 1].light : 1);
}
static double demi_body_give_at_most(const dem_world *w, int body) {
    return demi_give_at_most(w, w->bodies.inv_mass[body],
                             demi_shape_of(w, body) ? w->bodies.shape[body] : 0);
}
/* Computes the coefficients of two species. For equal radii R* is exactly half the radius, so that
   the result has the same bits as in a world of equal spheres. If one is of a cluster, the
   effective mass differs from contact to contact: then cn and ct lack the part that depends on it,
   and the two columns DEMI_CN_ROOT and DEMI_CT_ROOT hold its factors. */
static void demi_species_coefs(const dem_world *w, const demi_species *a, const demi_species *b,
                               dem_real *coef) {
    const double ra = (double)a->radius, rb = (double)b->radius;
    const double r_eff = ra < rb || ra > rb ? ra*rb/(ra + rb) : ra/2;
    const double sum = (double)a->inv_mass + (double)b->inv_mass;
    /* in that convention a fixed grain has a mass too */
    const double inv = w->desc.convention == DEM_CONVENTION_MILL
        ? 1/(double)a->mass + 1/(double)b->mass : sum;
    coef[DEMI_CN_ROOT] = coef[DEMI_CT_ROOT] = 0;
    if (a->shape || b->shape)
        demi_coefficients_rooted(w, a->material - 1, b->material - 1, r_eff,
                                 1/(demi_give_at_most(w, a->inv_mass, a->shape) +
                                    demi_give_at_most(w, b->inv_mass, b->shape)), 0, coef,
                                 coef + DEMI_CN_ROOT);
    else demi_coefficients(w, a->material - 1, b->material - 1, r_eff, 1/inv, 1/inv, 0, coef);
    coef[DEMI_M_EFF] = a->shape || b->shape ? 0 : (dem_real)(1/sum);
}
/* Determines which columns of coefficients differ between pairs and are read by a law. With a table
   it compares the rows. With too many species these are the columns that depend on radii and, if
   there are several materials, on materials. */
static void demi_species_vary(dem_world *w) {
    const int rows = w->effects.species_count*w->effects.species_count;
    const int fixed = 1 << DEMI_MU | 1 << DEMI_MU_STATIC | 1 << DEMI_MU_ROLL | 1 << DEMI_MU_SPIN;
    const int own = (1 << DEMI_COEFS) - (1 << DEMI_K_UN);
    int e, k, materials = 0;
    w->species_vary = (1 << DEMI_PAIR_COLUMNS) - 1;
    if (!demi_laws_sized(w)) w->species_vary &= ~(1 << DEMI_R_EFF);
    if (!demi_laws_sized(w) && !w->effects.clustered) w->species_vary &= ~(1 << DEMI_M_EFF);
    if (!w->effects.clustered) w->species_vary &= ~(1 << DEMI_CN_ROOT | 1 << DEMI_CT_ROOT);
    if (demi_many_species(w)) {
        for (k = 0; k < w->bodies.count; k++)
            materials |= w->bodies.material[k]^w->bodies.material[0];
        if (!materials) w->species_vary &= ~fixed;
        w->species_vary &= ~(own^demi_law_own(w));
        return;
    }
    for (e = 0; e < DEMI_PAIR_COLUMNS; e++) {
        const dem_real *column = w->species_coef + e;
        for (k = 1; k < rows; k++)
            if (memcmp(column, column + DEMI_PAIR_COLUMNS*k, sizeof *column)) break;
        if (k >= rows) w->species_vary &= ~(1 << e);
    }
}
/* True if coefficients for a new sphere are available without a rebuild. */
static int demi_species_known(const dem_world *w, int material, dem_real radius) {
    const demi_species *s = w->effects.species;
    int k;
    for (k = 0; k < w->effects.species_count && !demi_many_species(w); k++)
        if (s[k].material == material + 1 && s[k].inv_mass > 0 && !(s[k].radius < radius) &&
            !(s[k].radius > radius)) return 1;
    /* a second material would make further columns vary */
    return demi_many_species(w) &&
           (w->species_vary >> DEMI_MU & 1 || w->bodies.material[0] == material + 1);
}
/* Allocates the table. Returns 0 if memory runs out, before any list has changed. Filling the table
   (demi_species_lay) cannot fail. */
static int demi_species_room(dem_world *w) {
    const size_t n = demi_many_species(w) ? 0 : (size_t)w->effects.species_count;
    return DEMI_GROW(w, w->species_coef, n*n*DEMI_PAIR_COLUMNS);
}
/* Fills the table. */
static void demi_species_lay(dem_world *w) {
    const int n = w->effects.species_count;
    int k;
    for (k = 0; k < n*n && !demi_many_species(w); k++)
        demi_species_coefs(w, &w->effects.species[k/n], &w->effects.species[k%n],
                           w->species_coef + DEMI_PAIR_COLUMNS*k);
}
/* Returns the number of columns of coefficients in use. */
static int demi_coef_columns(const dem_world *w) {
    return w->effects.clustered ? DEMI_PAIR_COLUMNS : DEMI_TILE_COLUMNS;
}
/* Sets the row or the coefficients of entry p of work group d, a pair of spheres. Only needed if
   bodies differ. */
static void demi_near_coefs(const dem_world *w, demi_near *near, int d, int p) {
    const size_t at = (size_t)d*(size_t)near->stride + (size_t)p;
    const demi_species one = demi_near_species(w, at, 0), other = demi_near_species(w, at, 1);
    dem_real coef[DEMI_PAIR_COLUMNS], *to;
    int e;
    if (!demi_many_species(w)) {
        near->row[at] = demi_species_find(w, &one)*w->effects.species_count +
            demi_species_find(w, &other);
        return;
    }
    demi_species_coefs(w, &one, &other, coef);
    to = near->coef + (size_t)d*DEMI_PAIR_COLUMNS*(size_t)near->stride + (size_t)p;
    for (e = 0; e < demi_coef_columns(w); e++) to[(size_t)e*(size_t)near->stride] = coef[e];
}
/* Copies the coefficients of entry `from` of a list to entry `to` of the same or another list. */
static void demi_near_coefs_copy(const dem_world *w, demi_near *near, int d, int to,
                                 const demi_near *last, int from) {
    const size_t columns = DEMI_PAIR_COLUMNS, stride = (size_t)near->stride;
    const size_t last_stride = (size_t)last->stride, used = (size_t)demi_coef_columns(w);
    dem_real *m;
    const dem_real *old;
    size_t e;
    if (w->effects.uniform) return;
    if (!demi_many_species(w)) {
        near->row[d*near->stride + to] = last->row[d*last->stride + from];
        return;
    }
    m = near->coef + (size_t)d*columns*stride + (size_t)to;
    old = last->coef + (size_t)d*columns*last_stride + (size_t)from;
    for (e = 0; e < used; e++) m[e*stride] = old[e*last_stride];
}
/* Selects the pairs of lone spheres of the pruned list from a group's candidates. Writes them from
   entry p on and returns their end, or -1 if there is no room. mixed: 1 if there are also other
   bodies, whose pairs are left out. */
DEM_INLINE int demi_near_pick_as(dem_world *w, const demi_list *list, int begin, int end, int d,
                                 int p, int mixed) {
    const dem_real *x = w->bodies.pos, *u = w->bodies.vel, *shift = w->image_shift;
    const dem_real margin = demi_near_margin(w);
    const dem_real span = (dem_real)w->margin.span;
    const int room = w->near.stride - DEMI_LANES;
    const int32_t *shape = w->bodies.shape;
    int32_t *out = w->near.k + d*w->near.stride;
    int k;
    for (k = begin; k < end && p < room; k++) {
        const dem_real *a = DEMI_AT(x, list->a[k]), *b = DEMI_AT(x, list->b[k]);
        const dem_real *s = shift + list->image[k];
        const dem_real *ua = DEMI_AT(u, list->a[k]), *ub = DEMI_AT(u, list->b[k]);
        const dem_real dx = b[0] - a[0] + s[0], dy = b[1] - a[1] + s[1], dz = b[2] - a[2] + s[2];
        const dem_real ux = ub[0] - ua[0], uy = ub[1] - ua[1], uz = ub[2] - ua[2];
        const dem_real cut = a[3] + b[3] + margin + span*DEMI_SQRT(ux*ux + uy*uy + uz*uz);
        out[p] = k;
        p += (dx*dx + dy*dy + dz*dz < cut*cut) &
            (!mixed || !(shape[list->a[k]] | shape[list->b[k]]) ||      /* often: no lookup */
             (demi_lone(w, list->a[k]) && demi_lone(w, list->b[k])));
    }
    return k < end ? -1 : p;
}
/* Upper bound, m/s, on the approach speed of the surfaces of two bodies, rotation included. */
static dem_real demi_approach(const dem_world *w, int a, int b) {
    return demi_length(demi_sub(demi_at(w->bodies.vel + 4*b), demi_at(w->bodies.vel + 4*a))) +
        demi_turn_speed(w, a) + demi_turn_speed(w, b);
}
/* Gap, m, below which two bodies, or parts of them, may touch during the life of the list. */
static dem_real demi_near_cut(const dem_world *w, int a, int b) {
    return demi_near_margin(w) + (dem_real)w->margin.span*demi_approach(w, a, b);
}
/* Returns the spheres of a body, rows of centre (relative to the body's) and radius, m, and their
   number; null if the body has other parts. */
DEM_INLINE const dem_real *demi_balls_of(const dem_world *w, int body, int *count) {
    const demi_shape *shape = demi_shape_of(w, body);
    *count = shape ? shape->count : 1;
    return *count ? demi_centres_of(w, body) : 0;
}
/* True if the gap of two bodies, or of two of their parts, is below `cut`, m. shift: m, to the
   image of b. */
static int demi_bodies_near(const dem_world *w, int a, int b, const dem_real *shift, dem_real cut) {
    const dem_vec3 r = demi_add(demi_sub(demi_at(w->bodies.pos + 4*b),
                                         demi_at(w->bodies.pos + 4*a)), demi_at(shift));
    const dem_real far_b = demi_radius(w, b) + cut;
    const dem_real *x, *y;
    int na, nb, i, j;
    x = demi_balls_of(w, a, &na);
    y = demi_balls_of(w, b, &nb);
    if (!x || !y) return demi_bodies_gap(w, a, b, shift, cut) < cut;
    for (i = 0; i < na; i++, x += 4) {
        const dem_vec3 to = demi_sub(r, demi_at(x));
        const dem_real all = x[3] + far_b;
        if (!(demi_dot(to, to) < all*all)) continue;
        for (j = 0; j < nb; j++) {
            const dem_vec3 gap = demi_add(to, demi_at(y + 4*j));
            const dem_real near_by = x[3] + y[4*j + 3] + cut;
            if (demi_dot(gap, gap) < near_by*near_by) return 1;
        }
    }
    return 0;
}
/* True if a body consists of spheres. */
static int demi_has_balls(const dem_world *w, int body) {
    const demi_shape *shape = demi_shape_of(w, body);
    return !shape || shape->count;
}
/* True if the pruned list holds the pairs of spheres of two bodies, instead of the two bodies. */
static int demi_pair_of_balls(const dem_world *w, int a, int b) {
    return w->effects.clustered ? demi_has_balls(w, a) && demi_has_balls(w, b)
        : demi_lone(w, a) && demi_lone(w, b);
}
/* The same with clusters: selects the pairs of spheres of two bodies that may touch. */
static int demi_near_pick_balls(dem_world *w, const demi_list *list, int begin, int end, int d,
                                int p) {
    const int room = w->near.stride - DEMI_LANES, first = d*w->near.stride;
    int k, i, j;
    for (k = begin; k < end; k++) {
        const int a = list->a[k], b = list->b[k];
        const dem_vec3 r = demi_add(demi_sub(demi_at(w->bodies.pos + 4*b),
                                             demi_at(w->bodies.pos + 4*a)),
                                    demi_at(w->image_shift + list->image[k]));
        const dem_real cut = demi_near_cut(w, a, b), far_b = demi_radius(w, b) + cut;
        const dem_real all_a = demi_radius(w, a) + far_b;
        const int32_t *start = w->bodies.centre_start;
        if (!(demi_dot(r, r) < all_a*all_a) || !demi_has_balls(w, a) || !demi_has_balls(w, b))
            continue;
        for (i = start[a]; i < start[a + 1]; i++) {
            const dem_real *x = w->bodies.centre + 4*i;
            const dem_vec3 to = demi_sub(r, demi_at(x));
            const dem_real all = x[3] + far_b;
            if (!(demi_dot(to, to) < all*all)) continue;
            for (j = start[b]; j < start[b + 1]; j++) {
                const dem_real *y = w->bodies.centre + 4*j;
                const dem_vec3 gap = demi_add(to, demi_at(y));
                const dem_real near_by = x[3] + y[3] + cut;
                if (!(demi_dot(gap, gap) < near_by*near_by)) continue;
                if (p >= room) return -1;
                w->near.ball_a[first + p] = i;
                w->near.ball_b[first + p] = j;
                w->near.k[first + p++] = k;
            }
        }
    }
    return p;
}
static int demi_near_pick(dem_world *w, const demi_list *list, int begin, int end, int d, int p) {
    if (w->effects.clustered) return demi_near_pick_balls(w, list, begin, end, d, p);
    return w->effects.unlike ? demi_near_pick_as(w, list, begin, end, d, p, 1)
        : demi_near_pick_as(w, list, begin, end, d, p, 0);
}
/* As demi_near_pick for all other pairs: tests the gap of their surfaces. */
static int demi_near_pick_shaped(dem_world *w, const demi_list *list, int begin, int end, int d,
                                 int p) {
    const int room = w->near.stride - DEMI_LANES;
    int32_t *out = w->near.k + d*w->near.stride;
    int k;
    for (k = begin; k < end && p < room; k++) {
        const int a = list->a[k], b = list->b[k];
        dem_real cut;
        if (demi_pair_of_balls(w, a, b)) continue;
        cut = demi_near_cut(w, a, b);
        out[p] = k;
        p += demi_bodies_near(w, a, b, w->image_shift + list->image[k], cut);
    }
    return k < end ? -1 : p;
}
/* Sets the contact history and coefficients of entry p of work group d. from: its entry in the
   previous list, -1 if it is new or after a search; then saved history is used if there is any. */
static void demi_near_recall(dem_world *w, int d, int p, int from) {
    demi_near *near = &w->near;
    const demi_near *last = &w->near_last;
    const size_t keep = (size_t)w->memory_stride, stride = (size_t)near->stride;
    const size_t last_stride = (size_t)last->stride;
    const int at = d*near->stride + p;
    dem_real *m = near->memory + (size_t)d*keep*stride + (size_t)p;
    size_t e;
    int flip = 0;
    if (from >= 0) {
        const dem_real *old = last->memory + (size_t)d*keep*last_stride + (size_t)from;
        for (e = 0; e < keep; e++) m[e*stride] = old[e*last_stride];
        demi_near_coefs_copy(w, near, d, p, last, from);
        return;
    }
    if (!w->effects.uniform) demi_near_coefs(w, near, d, p);
    for (e = 0; e < keep; e++) m[e*stride] = 0;
    if (!keep || !w->near_fresh || (from = demi_carry_find(w, (size_t)at, &flip)) < 0) return;
    for (e = 0; e < keep; e++) {
        const dem_real value = w->filed.memory[(size_t)from*keep + e];
        m[e*stride] = flip && (w->vector_mask >> e & 1) ? -value : value;
    }
}

/* Returns how many pairs of two lone spheres come first among entries begin .. end - 1 of a work
   group's list; 0 without clusters. */
static int demi_near_lone(const dem_world *w, int d, int begin, int end) {
    const int32_t *a = w->near.a + d*w->near.stride, *b = w->near.b + d*w->near.stride;
    int p = begin;
    while (w->effects.clustered && p < end && demi_lone(w, a[p]) && demi_lone(w, b[p])) p++;
    return p - begin;
}
/* Completes the pruned list of a work group. Pads it to a multiple of DEMI_LANES with copies of the
   last pair, whose results are ignored, so that every vector is full. Counts pairs of lone spheres.
   Stores in each candidate its entry in the pruned list. */
static void demi_near_adopt(dem_world *w, int d) {
    demi_near *near = &w->near;
    demi_domain *domain = &w->domains[d];
    const size_t stride = (size_t)near->stride;
    dem_real *memory = w->memory_stride
        ? near->memory + (size_t)d*(size_t)w->memory_stride*stride : 0;
    int l, p, e;
    for (l = 0; l < 2; l++) {
        const int end = l ? domain->near_end : domain->near_own, at = d*near->stride;
        const int begin = l ? domain->near_cross : 0;
        domain->near_lone[l] = demi_near_lone(w, d, begin, end);
        if (end == begin) continue;
        for (p = end; p%DEMI_LANES; p++) {
            near->a[at + p] = near->a[at + end - 1];
            near->b[at + p] = near->b[at + end - 1];
            near->k[at + p] = near->k[at + end - 1];
            near->image[at + p] = near->image[at + end - 1];
            if (w->effects.clustered) {
                near->ball_a[at + p] = near->ball_a[at + end - 1];
                near->ball_b[at + p] = near->ball_b[at + end - 1];
            }
            for (e = 0; e < w->memory_stride; e++) memory[(size_t)e*stride + (size_t)p] = 0;
            demi_near_coefs_copy(w, near, d, p, near, end - 1);
        }
    }
    for (p = domain->near_shaped; p < domain->near_shaped_end && !w->effects.clustered; p++)
        near->balls[d*near->stride + p].count = DEMI_BALLS_UNKNOWN;
    for (l = 0; l < 2; l++) {
        demi_list *list = l ? &w->cross : &w->own;
        const int count = l ? domain->cross : domain->own;
        if (count) memset(list->place + d*list->stride, 0, (size_t)count*sizeof *list->place);
        for (p = (l ? domain->near_end : domain->near_own) - 1; p >= (l ? domain->near_cross : 0);
             p--) list->place[near->k[d*near->stride + p]] = p + 1;     /* the first of several */
        for (p = l ? domain->near_shaped_cross : domain->near_shaped;
             p < (l ? domain->near_shaped_end : domain->near_shaped_cross); p++)
            list->place[near->k[d*near->stride + p]] = p + 1;
    }
}
/* Makes the list that was built the current one. */
static void demi_domain_adopt(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    domain->near_own = domain->near_next_own;
    domain->near_cross = domain->near_next_cross;
    domain->near_end = domain->near_next_end;
    domain->near_shaped = domain->near_next_shaped;
    domain->near_shaped_cross = domain->near_next_shaped_cross;
    domain->near_shaped_end = domain->near_next_shaped_end;
    demi_near_adopt(w, d);
}

/* --- sheets: bodies on both sides of a surface without thickness do not touch --- */

/* True if the segment from x to x + to, in the frame of a surface, crosses an element. */
static int demi_element_crossed(const demi_wall *wall, int element, dem_vec3 x, dem_vec3 to) {
    const dem_real *plane = wall->planes + 4*element;
    const dem_vec3 n = demi_at(plane);
    const dem_real here = demi_dot(n, x) - plane[3], there = here + demi_dot(n, to);
    dem_vec3 c[3], p;
    int i, corners, sides = 0;
    if ((here > 0) == (there > 0)) return 0;
    p = demi_add(x, demi_scale(to, here/(here - there)));
    corners = demi_wall_corners(wall, element, c);
    for (i = 0; i < corners; i++) {
        const dem_vec3 e = demi_sub(c[(i + 1)%corners], c[i]), d = demi_sub(p, c[i]);
        const dem_real hair = DEM_R(-1e-6)*demi_dot(e, e);
        sides += corners == 2 ? e.x*d.x + e.y*d.y > hair : demi_dot(n, demi_cross(e, d)) > hair;
    }
    return sides == corners;
}
/* True if a sheet among the candidates of `body` crosses the line from its centre to that of
   `other`, which must not ignore it. to: m, to the image of the other. */
static int demi_sheet_before(const dem_world *w, int body, int other, dem_vec3 to) {
    dem_vec3 from = to, way = to, x;
    int k, had = -1;
    for (k = w->walled[body].first; k < w->walled[body].end; k++) {
        const demi_wall *wall = demi_surface_of(w, w->wall_id[k]);
        const demi_wall *whole = wall->scale ? &w->walls[wall->lead] : wall;
        const dem_real *shift = w->wall_shift + 3*(size_t)k, *R = wall->pose.rotation;
        if (!wall->open || (w->effects.ignoring &&
            demi_ignores(w, w->bodies.material[other] - 1, wall->material))) continue;
        if (had < 0 || w->wall_id[k] != w->wall_id[had] ||
            memcmp(shift, w->wall_shift + 3*(size_t)had, 3*sizeof *shift)) {
            from = demi_unrotate(R, demi_sub(demi_add(demi_at(w->bodies.pos + 4*body),
                                                      demi_at(shift)), wall->pose.position));
            way = demi_unrotate(R, to);
            if (!demi_faceted(whole) && demi_round_crossed(whole, from, way)) return 1;
            had = k;
        }
        if (!demi_faceted(whole)) continue;
        x = from;
        if (wall->step[0].x > 0) x = demi_sub(x, demi_cell_shift(wall, w->wall_cell[k], x));
        if (demi_element_crossed(wall, w->wall_element[k], x, way)) return 1;
    }
    return 0;
}
/* The distance from body i, m, within which no sheet was when the candidates were listed: at most
   demi_cover; -DEMI_ONLY_SHEET if it is not known, or if bodies have their own tessellations. */
static dem_real demi_sheet_free(const dem_world *w, int i) {
    return w->effects.scales ? -DEMI_ONLY_SHEET : DEMI_MIN(w->walled[i].gap, demi_cover(w));
}
/* True if a sheet lies between bodies a and b: if the line between their centres crosses it. The
   distances of the crossing from the two spheres add up to their gap (0.999: for rounding), so it
   is no farther from each than the gap less what is free of sheets around the other, and is among
   the candidates of each sphere that is so near to it. to: m, from a to the image of b. */
static int demi_sheet_between(const dem_world *w, int a, int b, dem_vec3 to) {
    const dem_real gap = demi_length(to) - DEM_R(0.999)*(demi_radius(w, a) + demi_radius(w, b)) +
        2*(dem_real)(w->margin.gone + w->margin.walls_gone);
    const dem_real free_a = demi_sheet_free(w, a), free_b = demi_sheet_free(w, b);
    if (gap < free_a + free_b) return 0;
    if (gap - free_b < demi_cover(w)) return demi_sheet_before(w, a, b, to);
    return demi_sheet_before(w, b, a, demi_scale(to, -1)) ||
           (gap - free_a >= demi_cover(w) && demi_sheet_before(w, a, b, to));
}
/* Removes pairs on both sides of a sheet from entries first .. end - 1 of the pruned list of a work
   group. Returns the new end. */
static int demi_near_part(const dem_world *w, const demi_list *list, int d, int first, int end) {
    int32_t *out = w->near.k + d*w->near.stride;
    int q, left = first, last = -1, parted = 0;
    if (!w->sheeted) return end;
    for (q = first; q < end; q++) {
        const int k = out[q], a = list->a[k], b = list->b[k];
        if (k != last)
            parted = (w->by_sheet[a] || w->by_sheet[b]) &&
                demi_sheet_between(w, a, b, demi_add(demi_at(w->image_shift + list->image[k]),
                    demi_sub(demi_at(w->bodies.pos + 4*b), demi_at(w->bodies.pos + 4*a))));
        last = k;
        if (parted) continue;
        if (w->effects.clustered) {
            w->near.ball_a[d*w->near.stride + left] = w->near.ball_a[d*w->near.stride + q];
            w->near.ball_b[d*w->near.stride + left] = w->near.ball_b[d*w->near.stride + q];
        }
        out[left++] = k;
    }
    return left;
}

/* Moves the pairs of two lone spheres to the front of entries first .. end - 1, so that >>pairs can
   compute them in full tiles. Both kinds keep their order. near.hit is used as temporary memory. */
static void demi_near_lone_first(dem_world *w, const demi_list *list, int d, int first, int end) {
    const int at = d*w->near.stride;
    int32_t *column[3], *aside = w->near.hit + at;
    int e, p, others, left;
    column[0] = w->near.ball_a + at; column[1] = w->near.ball_b + at; column[2] = w->near.k + at;
    for (e = 0; e < 3; e++) {                   /* k last, because the test reads it */
        for (p = left = first, others = 0; p < end; p++) {
            const int k = w->near.k[at + p], value = column[e][p];
            if (demi_lone(w, list->a[k]) && demi_lone(w, list->b[k])) column[e][left++] = value;
            else aside[others++] = value;
        }
        for (p = 0; p < others; p++) column[e][left + p] = aside[p];
    }
}
/* Returns the entry in the previous list of the pair of spheres at index `at` of the present one,
   or -1. Those of one candidate are adjacent. */
static int demi_near_was(const dem_world *w, const demi_list *list, int d, int at) {
    const demi_near *last = &w->near_last;
    const int k = w->near.k[at], base = d*last->stride;
    const int end = base + w->domains[d].near_end;
    int p = base + list->place[k] - 1;
    if (!w->effects.clustered || p < base) return p - base;
    for (; p < end && last->k[p] == k; p++)
        if (last->ball_a[p] == w->near.ball_a[at] && last->ball_b[p] == w->near.ball_b[at])
            return p - base;
    return -1;
}
/* Builds the pruned list of a work group: first the pairs of spheres, then the others; in both, the
   pairs inside the group, then those with later groups. Sets `overflow` if there is no room. */
static void demi_domain_near(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    demi_near *near = &w->near;
    int l, q, p = 0, run = 0;
    domain->overflow &= ~8;
    domain->merging = 0;
    for (l = 0; l < 2; l++) {
        const demi_list *list = l ? &w->cross : &w->own;
        const int begin = d*list->stride, end = begin + (l ? domain->cross : domain->own);
        const int first = p;
        p = demi_near_pick(w, list, begin, end, d, p);
        if (p < 0) { domain->overflow |= 8; return; }
        p = demi_near_part(w, list, d, first, p);
        if (w->effects.clustered) demi_near_lone_first(w, list, d, first, p);
        for (q = first; q < p; q++) {
            const int at = d*near->stride + q, k = near->k[at];
            near->a[at] = list->a[k];
            near->b[at] = list->b[k];
            near->image[at] = list->image[k];
            if (w->effects.clustered) {
                near->on[at] = 1;
                run = q > first && near->k[at - 1] == k ? run + 1 : 1;
                domain->merging = DEMI_MAX(domain->merging, run);
            }
            if (w->memory_stride || !w->effects.uniform)
                demi_near_recall(w, d, q, w->near_fresh ? -1 : demi_near_was(w, list, d, at));
        }
        if (l) domain->near_next_end = p;
        else domain->near_next_own = p;
        p = (p + DEMI_LANES - 1)/DEMI_LANES*DEMI_LANES;
        if (!l) domain->near_next_cross = p;
    }
    domain->near_next_shaped = p;
    for (l = 0; l < 2; l++) {
        const demi_list *list = l ? &w->cross : &w->own;
        const int begin = d*list->stride, end = begin + (l ? domain->cross : domain->own);
        const int first = p;
        if (l) domain->near_next_shaped_cross = p;
        if (w->effects.unlike) p = demi_near_pick_shaped(w, list, begin, end, d, p);
        if (p < 0) { domain->overflow |= 8; return; }
        p = demi_near_part(w, list, d, first, p);
        for (q = first; q < p; q++) {
            const int at = d*near->stride + q, k = near->k[at];
            near->a[at] = list->a[k];
            near->b[at] = list->b[k];
            near->image[at] = list->image[k];
        }
    }
    domain->near_next_shaped_end = p;
}
/* --- isolated bodies ("quiet"). If only contacts can act (no gravity, no force field, no other
       slab), a body without a pair in the pruned list and without a wall candidate moves in a
       straight line until the next pruned list. Then a step only changes its position. Isolation is
       stored for blocks of DEMI_SOME bodies. Skipping the rest of the step leaves exactly the
       values that computing it would write, so the bits are the same. --- */
typedef struct demi_quiet {
    int restless;                  /* 2: forces may act; 1: not now, but before; 0: isolated */
    dem_real speed2;               /* (m/s)^2, largest |v|^2 when it was last computed */
} demi_quiet;
/* Returns the block of body i. */
DEM_INLINE demi_quiet *demi_quiet_at(const dem_world *w, int d, int i) {
    return w->quiet + d + i/DEMI_SOME;     /* work groups never share a block */
}
static int demi_quiet_reserve(dem_world *w, int bodies) {
    return DEMI_GROW(w, w->quiet, (size_t)(bodies/DEMI_SOME + w->domain_count + 1));
}
/* True if bodies of this scene can be isolated. */
static int demi_quiet_possible(const dem_world *w) {
    const dem_vec3 g = w->desc.gravity;
    return !(demi_dot(g, g) > 0) && !w->desc.force && !w->desc.body_force && !w->bodies.ghost &&
           (!w->bodies.backward || demi_response_is(w, DEMI_MIDWAY)) && !w->joint_count &&
           !w->rail_count && !w->cell.on;
}
/* Marks the blocks of a work group whose bodies have pairs in the pruned list or wall candidates.
   For the other blocks a step neither collects nor clears forces. */
static void demi_domain_quiet(dem_world *w, int d) {
    const demi_domain *domain = &w->domains[d];
    const demi_near *near = &w->near;
    int i, p, k;
    for (i = domain->begin; i < domain->end; i++) demi_quiet_at(w, d, i)->restless = 1;
    for (p = demi_near_first(domain); p < domain->near_end; p = demi_near_next(domain, p)) {
        demi_quiet_at(w, d, near->a[d*near->stride + p])->restless = 2;
        if (p < domain->near_own) demi_quiet_at(w, d, near->b[d*near->stride + p])->restless = 2;
    }
    for (p = domain->near_shaped; p < domain->near_shaped_end; p++) {
        demi_quiet_at(w, d, near->a[d*near->stride + p])->restless = 2;
        if (p < domain->near_shaped_cross)
            demi_quiet_at(w, d, near->b[d*near->stride + p])->restless = 2;
    }
    for (k = w->cross_incoming_start[d]; k < w->cross_incoming_start[d + 1]; k++)
        if (w->cross.place[w->cross_incoming[k]])
            demi_quiet_at(w, d, w->cross.b[w->cross_incoming[k]])->restless = 2;
    for (k = 0; k < domain->walls; k++)
        demi_quiet_at(w, d, w->wall_body[d*w->wall_stride + k])->restless = 2;
}
/* Marks the blocks of all work groups, if bodies can be isolated, for the present lists. */
static void demi_quiet_mark(dem_world *w) {
    w->stage.quiet = demi_quiet_possible(w);
    if (w->stage.quiet) demi_domains_do(w, demi_domain_quiet);
}

/* Chooses span and slack of the next pruned list. The cost is estimated from counts, not from time,
   so that every run makes the same choice: 1 for a force, and for building the list 0.15 for each
   candidate and 1 for each of its pairs (bench/ measures both). With a longer span the list
   contains more pairs that do not touch, and is built less often. Those within the range of the law
   are in it whatever the span. */
static void demi_near_choose(dem_world *w) {
    const double r = (double)(w->effects.radius_min > 0 ? w->effects.radius_min : 1),
        dt = (double)w->clock.dt;
    double near = 0, touching = 0, candidates = 0, longer = 1, span = w->margin.span, beyond;
    int d;
    if (span < dt) span = dt;                   /* the first list */
    if (w->margin.age > 0) {
        for (d = 0; d < w->domain_count; d++) {
            const demi_domain *domain = &w->domains[d];
            near += domain->near_own + domain->near_end - domain->near_cross;
            near += 4*(domain->near_shaped_end - domain->near_shaped);
            touching += domain->contacts + 3*(domain->persistent - domain->persistent_walls);
            candidates += domain->own + domain->cross;
        }
        if (w->effects.unlike) candidates *= 6;   /* support points, some gaps */
        beyond = w->margin.slack + span*w->margin.pace;
        beyond = (near - touching)*(w->margin.cover > 0 ? beyond/(w->margin.cover + beyond) : 1);
        longer = sqrt((0.15*candidates + near)*dt/
                      (w->margin.age*DEMI_MAX(beyond, 0.01*w->bodies.count)));
        longer = sqrt(DEMI_MIN(DEMI_MAX(longer, 0.5), 2.0));
        span = DEMI_MIN(DEMI_MAX(w->margin.age*longer, 2*dt), 1000*dt);
        /* creep grows with the square of time */
        w->margin.slack = w->margin.creep*span*span/(w->margin.age*w->margin.age)*1.2;
    }
    w->margin.slack = DEMI_MIN(DEMI_MAX(w->margin.slack, 1e-5*r), 0.1*r);
    w->margin.span = span;
}
/* Records a step in which no velocity changed by more than `change`, m/s. */
static void demi_near_pass(dem_world *w, double change) {
    w->margin.last_change = change;
    w->margin.change += change;
    w->margin.creep += 2*w->margin.change*(double)w->clock.dt + w->cell.squeeze;
    w->margin.age += (double)w->clock.dt;
}
/* True if span or slack of the pruned list are used up. */
static int demi_near_worn(const dem_world *w) {
    return w->margin.age > w->margin.span*(1 - 1e-9) || w->margin.creep > w->margin.slack;
}
/* True if the pruned list must be rebuilt. */
static int demi_near_due(const dem_world *w) {
    return demi_near_worn(w) || (demi_reach_free(w) && demi_foreseen(w) > w->margin.cover);
}
/* Allocates the contacts of two bodies that >>members may merge. Returns 0 if memory runs out. */
static int demi_merging_reserve(dem_world *w) {
    int d, most = 0;
    for (d = 0; d < w->domain_count; d++) most = DEMI_MAX(most, w->domains[d].merging);
    if (w->laws.at_grip == DEMI_MEMORY) return 1;
    if (!DEMI_GROW(w, w->merging, (size_t)w->domain_count*(size_t)most)) return 0;
    w->merging_most = most;
    return 1;
}
/* Builds the pruned list; fresh: 1 after a search. Returns 0 if memory runs out; the previous list
   then stays in use. */
static int demi_near_make(dem_world *w, int fresh) {
    const demi_near swap = w->near;
    int d, again, stride;
    w->near = w->near_last;
    w->near_last = swap;
    w->near_fresh = fresh;
    w->margin.cover = DEMI_MIN(w->margin.reach, 1.5*demi_foreseen(w));
    if (!demi_quiet_reserve(w, w->bodies.count)) {
        w->near_last = w->near;
        w->near = swap;
        return 0;
    }
    stride = DEMI_MAX(w->near_last.stride, DEMI_MAX(64, w->bodies.count/w->domain_count*5/2));
    stride = (stride + DEMI_LANES - 1)/DEMI_LANES*DEMI_LANES;
    do {                                        /* until the pairs of every group fit */
        again = 0;
        if (demi_near_reserve(w, &w->near, w->domain_count, stride)) {
            demi_domains_do(w, demi_domain_near);
            for (d = 0; d < w->domain_count; d++) again |= w->domains[d].overflow & 8;
            stride = stride/4*5/DEMI_LANES*DEMI_LANES + 4*DEMI_LANES;
            continue;
        }
        w->near_last = w->near;
        w->near = swap;
        return 0;
    } while (again);
    if (!demi_merging_reserve(w)) {
        w->near_last = w->near;
        w->near = swap;
        return 0;
    }
    demi_domains_do(w, demi_domain_adopt);
    if (!fresh) demi_quiet_mark(w);
    w->margin.age = w->margin.creep = 0;
    w->stage.near_stale = 0;
    /* the velocities used here and those of the next move may differ by this much */
    w->margin.change = w->margin.last_change;
    return 1;
}
