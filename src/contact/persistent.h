/* ---------------------------------------------------------------------------------------------
   >>persistent
   Contact detection for persistent contacts: all contacts except those of sphere on sphere (with
   springs also of spheres of clusters), which >>respond and >>members handle without such a list.
   Two such bodies may touch at several points, with normals that do not pass through their centres,
   and a body touches a wall once per nearby surface. These contacts are therefore stored one by one
   in a list (demi_persistent) and followed from step to step, so that each keeps its history.

   The function demi_touch builds the list of the present step. It finds the contact points (part
   against part by >>meets, part against wall element by >>touch) and decides which contact of the
   step before each one continues. >>persistent-respond then continues the history, evaluates the
   contact law and adds the forces. Within a work group the list is ordered by body a. If a list is
   too short, demi_touch enlarges it and starts again; this loses nothing, since the old list is
   untouched.
   --------------------------------------------------------------------------------------------- */

/* True if the law is evaluated for contact c: if the two overlap, or if the law has a range. False
   for a body on its way through a hole of a reduced sieve, whose weight is 0. */
DEM_INLINE int demi_persistent_asked(const dem_world *w, const demi_persistent *c) {
    return c->overlap > 0 || (w->margin.reach > 0 && (c->weight < 0 || c->weight > 0));
}
/* Prefetches what the next step needs of the contact `by` entries after k or, with `all`, the
   fields that every contact uses. That entry may lie beyond the end of the list. */
DEM_INLINE void demi_persistent_ahead(const demi_persistent *k, size_t by, int all) {
    const uintptr_t at = (uintptr_t)k + by*sizeof *k;
    size_t e;
    DEMI_UNROLL
    for (e = 0; e < offsetof(demi_persistent, memory) + 3*sizeof(dem_real); e += 64)
        DEMI_FETCH((const void *)(at + e));
    if (!all) return;
    DEMI_UNROLL
    for (e = offsetof(demi_persistent, arm_b); e < offsetof(demi_persistent, more); e += 64)
        DEMI_FETCH((const void *)(at + e));
}
/* Clears all of a contact but its history, which respond writes, and `more`. */
DEM_INLINE void demi_persistent_blank(demi_persistent *c) {
    memset(c, 0, offsetof(demi_persistent, memory));
    memset(&c->arm_b, 0, offsetof(demi_persistent, more) - offsetof(demi_persistent, arm_b));
}
/* Appends a contact to the new list of work group d and returns it, cleared except for its history
   and `more`. Returns null if the list is full. */
static demi_persistent *demi_persistent_new(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    demi_persistent *c;
    if (domain->persistent_next >= w->persistent_first[d + 1] - w->persistent_first[d]) {
        domain->overflow |= 16;
        return 0;
    }
    c = w->persistent_next + w->persistent_first[d] + domain->persistent_next++;
    demi_persistent_blank(c);
    c->b = -1;
    c->share = c->slope = 1;
    return c;
}
DEM_INLINE dem_vec3 demi_persistent_spread_of(const demi_persistent *c) {
    return c->odd ? c->more.spread : demi_v(0, 0, 0);
}
DEM_INLINE dem_vec3 demi_persistent_felt(const demi_persistent *c) {
    return c->odd ? c->more.felt : demi_v(0, 0, 0);
}
/* Copies a new contact, for which no force has been computed yet. */
static void demi_persistent_copy(demi_persistent *to, const demi_persistent *from) {
    memcpy(to, from, offsetof(demi_persistent, more));
    if (from->odd) to->more = from->more;
}

/* Similarity t of two contacts of the same pair: 1 if their normals are within 25 degrees, 0 beyond
   45 degrees, smooth in between. *rate receives its derivative with respect to the cosine of that
   angle. */
DEM_INLINE dem_real demi_persistent_along(const demi_persistent *a, const demi_persistent *b,
                                          dem_real *rate) {
    const dem_real zero = DEM_R(0.7071067811865476), one = DEM_R(0.9063077870366499);
    const dem_real t = (demi_dot(a->normal, b->normal) - zero)/(one - zero);
    *rate = t > 0 && t < 1 ? 6*t*(1 - t)/(one - zero) : 0;
    return !(t > 0) ? 0 : t < 1 ? t*t*(3 - 2*t) : 1;
}
/* Like demi_persistent_along, but 0 for contacts of the same two parts: their weights already
   account for overlap. */
DEM_INLINE dem_real demi_persistent_alike(const demi_persistent *a, const demi_persistent *b,
                                          dem_real *rate) {
    *rate = 0;
    return a->part_a == b->part_a && a->part_b == b->part_b ? 0 : demi_persistent_along(a, b, rate);
}
/* Adds to `aside` the tangential force on contact c's sphere that arises because c's normal
   rotates towards or away from the normal `other` as the sphere moves: -(dE/dt)(dt/dcos)
   d(n.other)/dx. `push` is the product of the first two factors, over U'(d) of contact c. */
DEM_INLINE void demi_persistent_aside(demi_persistent *c, dem_vec3 other, dem_real push) {
    demi_persistent_more *m = demi_persistent_odd(c);
    const dem_real along = demi_dot(other, m->axis);
    dem_vec3 turn = demi_sub(other, demi_scale(c->normal, demi_dot(other, c->normal)));
    turn = demi_sub(turn, demi_scale(m->axis, along));
    turn = demi_add(demi_scale(turn, c->bend), demi_scale(m->axis, along*m->along));
    m->aside = demi_add(m->aside, demi_scale(turn, push));
}
/* Exponent of R* in the stiffness of a contact: 1/2 for Hertz; for a linear law 2/5, or 0 if the
   stiffness is given. */
static dem_real demi_persistent_power(const dem_world *w, const demi_persistent *c) {
    const int a = w->bodies.material[c->a] - 1;
    const int b = c->b < 0 ? w->walls[c->wall].material : w->bodies.material[c->b] - 1;
    if (demi_normal_is(w, DEMI_HERTZIAN)) return DEM_R(0.5);
    return w->pairs[a*DEMI_MATERIALS + b].given.stiffness > 0 ? DEM_R(0) : DEM_R(0.4);
}
/* Returns U'(d_i)/U'(d_k) for two contacts that overlap. q: exponent of R*, see
   demi_persistent_power. */
static dem_real demi_persistent_steep(const demi_persistent *i, const demi_persistent *k, int hertz,
                                      dem_real q) {
    const dem_real more = i->overlap/k->overlap, R = i->r_eff/k->r_eff;
    if (hertz) return more*DEMI_SQRT(more*R);
    return q > 0 && (R < 1 || R > 1) ? more*(dem_real)demi_pow((double)R, (double)q) : more;
}
/* Sets lift, aside and grip of the n contacts of a pair from the gradient of the merged energy E
   (see demi_persistent_share). Their shares and areas must be known. */
static void demi_persistent_lift(const dem_world *w, demi_persistent *c, int n) {
    const int hertz = demi_normal_is(w, DEMI_HERTZIAN);
    const dem_real p = hertz ? DEM_R(2.5) : DEM_R(2), q = demi_persistent_power(w, c);
    dem_real rate;
    int i, k;
    for (k = 0; k < n; k++) {
        const dem_real d = c[k].overlap, own = c[k].share*d/p;     /* E_k/U'(d_k) */
        if (!(d > 0)) continue;
        c[k].lift = c[k].share*(1 + 2/p*c[k].more.rate*c[k].more.added*d*d/c[k].more.area);
        for (i = 0; i < n; i++) {
            const dem_real t = i == k ? 0 : demi_persistent_alike(&c[i], &c[k], &rate);
            const dem_real e = c[i].overlap;
            dem_real far;                       /* E_i/(U'(d_k) A_i) */
            if (!(t > 0) || !(e > 0)) continue;
            far = demi_persistent_steep(&c[i], &c[k], hertz, q)*c[i].share*e/p*
                c[i].more.rate/c[i].more.area;
            c[k].lift -= far*2*t*c[k].weight*d;
            if (rate > 0 && !(w->margin.reach > 0))
                demi_persistent_aside(&c[k], c[i].normal, rate*(far*c[k].weight*d*d +
                                  own*c[k].more.rate/c[k].more.area*c[i].weight*e*e));
        }
    }
    for (k = 0; k < n; k++) {
        dem_real lift = 0, share = 0, own = 0;
        if (!(c[k].overlap > 0)) continue;
        for (i = 0; i < n; i++) {
            const dem_real t = i == k ? 1 : demi_persistent_along(&c[i], &c[k], &rate);
            dem_real press;                     /* U'(d_i)/U'(d_k), times t */
            if (!(t > 0) || !(c[i].overlap > 0)) continue;
            press = t*demi_persistent_steep(&c[i], &c[k], hertz, q);
            lift += press*c[i].lift;
            share += press*c[i].share;
            if (i == k) own = press;
        }
        if (share > DEM_R(0.1)*own && lift > 0) c[k].grip = c[k].share*lift/share;
        else c[k].grip = c[k].share;
    }
}
/* Returns A_i/d_i^2 = 1 + x of demi_persistent_share, where x is the sum of the other terms over
   d_i^2. If negative weights (>>facets) make x less than -1/2, the value decreases smoothly to no
   less than 1/4. *rate receives its derivative with respect to x. */
static dem_real demi_persistent_room_of(dem_real x, dem_real *rate) {
    const dem_real below = DEM_R(0.0625)/(DEM_R(-0.25) - x);    /* x < -1/2 */
    *rate = x < DEM_R(-0.5) ? 16*below*below : DEM_R(1);
    return x < DEM_R(-0.5) ? DEM_R(0.25) + below : 1 + x;
}
/* True if a body is a cluster of spheres. */
static int demi_is_cluster(const dem_world *w, int body) {
    const demi_shape *shape = demi_shape_of(w, body);
    return shape && shape->count;
}
/* Merges contacts c[0] .. c[n - 1] of one pair, or of a body and all walls, so that together they
   act as one (DEM_CLUSTER_CONTACTS_MERGED). With overlaps d, weights w (those of >>facets,
   otherwise 1), the elastic energy U(d) of a contact and the similarity t_ij of two normals
   (demi_persistent_along),
       A_i = d_i^2 + sum of t_ij w_j d_j^2, j not i;   s_i = w_i d_i^2/A_i;   E = sum of s_i U(d_i)
   This is a mean in which deeper contacts count more. Similar contacts together store the energy of
   one, whatever their number, and a contact that begins or ends counts nothing. Stiffness, damping
   and restitution therefore do not grow with the number of spheres that touch [BER23]. The elastic
   force is the gradient of E, so energy is conserved. It acts along the normal of contact k with
   dE/dd_k = lift_k U'(d_k), and across it as far as t depends on the rotation of the normal with
   the sphere's position (`aside`). With U ~ sqrt(R) d^p (Hertz) or d^p:
       E_i = s_i U'(d_i) d_i/p,          dE_k/dd_k = s_k U'(d_k) (1 + 2/p (A_k - d_k^2)/A_k)
       dE_i/dd_k = -E_i 2 t_ik w_k d_k/A_i,    dE_i/dt_ik = -E_i w_k d_k^2/A_i
   Neglected: the rotation of the normal of an ellipsoid, or at an edge of a polyhedron, against a
   cluster's sphere; and `aside` for laws with a range, which attract: their U is no such power, so
   that the torques of two contacts would not cancel. If the centre of a sphere is within a tenth of
   its radius of what it rolls around, its normal rotates no faster than at that distance. Pieces of
   unions are not merged: their energies add.

   lift_k may be slightly negative if other contacts are far deeper; no mean that is independent of
   the number of contacts avoids this. Contacts within the range of a law that do not overlap keep
   their weight. Damping is scaled by s (`share`) and uses the effective mass at the common centre
   of the contacts. Friction is scaled by `grip` = s (sum of lift U')/(sum of s U'), so that mu is
   the ratio of the two total forces. Tests: "a cluster landing on one, two or three spheres" and
   tests/surface/test_facets.c. */
static void demi_persistent_share(const dem_world *w, demi_persistent *c, int n) {
    const int one = n > 1 && w->desc.cluster_contacts == DEM_CLUSTER_CONTACTS_MERGED &&
        (demi_is_cluster(w, c->a) || (c->b >= 0 && demi_is_cluster(w, c->b)));
    int i, j;
    for (i = 0; i < n; i++) {
        const dem_real d2 = c[i].overlap*c[i].overlap;
        dem_vec3 mean;                          /* common centre as seen from a, times A */
        dem_real A = d2, rate;
        demi_persistent_more *m;
        c[i].weight = c[i].lift = c[i].grip = c[i].share;
        if (c[i].odd) c[i].more.felt = c[i].more.spread;   /* polyhedra: the centre of pressure */
        if (!one || !(c[i].overlap > 0)) continue;
        mean = demi_scale(demi_sub(c[i].arm_a, demi_persistent_spread_of(&c[i])), d2);
        for (j = 0; j < n; j++) {
            const dem_real t = j == i ? 0 : demi_persistent_alike(&c[i], &c[j], &rate);
            const dem_real add = t*c[j].overlap*c[j].overlap*(j < i ? c[j].weight : c[j].share);
            if (!(t > 0) || !(c[j].overlap > 0)) continue;
            A += add;
            mean = demi_add(mean, demi_scale(demi_sub(c[j].arm_a,
                                                      demi_persistent_spread_of(&c[j])), add));
        }
        m = demi_persistent_odd(&c[i]);
        m->added = A/d2 - 1;
        m->area = d2*demi_persistent_room_of(m->added, &m->rate);
        c[i].share = c[i].weight*d2/m->area;
        if (A > d2/2)                           /* else negative weights prevail */
            m->felt = demi_sub(c[i].arm_a, demi_scale(mean, 1/A));
    }
    if (one) demi_persistent_lift(w, c, n);
}

/* Sets `held` of n contacts of one body with one partner or wall: the grip (weight of friction)
   that each inherits from the step before. Contacts that continue the same old one divide its grip
   in proportion to their own. Of a contact in parts all have that of all its parts. now: the old
   list of the work group. */
static void demi_persistent_inherit(const demi_persistent *now, demi_persistent *c, int n) {
    int i, k;
    if (n == 1) { c->held = -1; return; }       /* do not load the old one yet */
    for (k = 0; k < n; k++) {
        const dem_real own = demi_persistent_whole(&c[k]);
        dem_real all = 0;
        if (c[k].from < 0) continue;
        if (demi_persistent_later(&c[k])) { c[k].held = c[k - c[k].corners].held; continue; }
        for (i = 0; i < n; i++)
            if (c[i].from == c[k].from && !demi_persistent_later(&c[i]))
                all += demi_persistent_whole(&c[i]);
        c[k].held = demi_persistent_whole(&now[c[k].from]);
        if (all > own) c[k].held *= own/all;
    }
}
/* Splits contact c of two polyhedra into the four corners of the parallelogram over which its
   pressure is spread; `spread` and `aside` are its half edges. Returns 0 if the list is full. */
static int demi_persistent_spread(dem_world *w, int d, demi_persistent *c,
                                  const demi_persistent *old, int olds) {
    demi_persistent_more *m = demi_persistent_odd(c);
    const dem_vec3 one = m->spread, two = m->aside;
    dem_vec3 to = one;
    int k;
    m->aside = demi_v(0, 0, 0);
    c->share /= (dem_real)c->corners;
    for (k = c->corners - 1; k >= 0; k--) {
        demi_persistent *at = k ? demi_persistent_new(w, d) : c;
        if (!at) return 0;
        if (k) demi_persistent_copy(at, c);
        at->corner = k;
        if (k) at->from = demi_persistent_same(w, d, old, olds, at);
        to = demi_add(demi_scale(one, k & 2 ? DEM_R(-1) : DEM_R(1)),
                      demi_scale(two, k & 1 ? DEM_R(-1) : DEM_R(1)));
        at->more.spread = to;
        if (k) {
            at->arm_a = demi_add(c->arm_a, to);
            at->arm_b = demi_add(c->arm_b, to);
        }
    }
    c->arm_a = demi_add(c->arm_a, to);
    c->arm_b = demi_add(c->arm_b, to);
    demi_persistent_turn(w, d, c);
    return 1;
}
/* Splits contact c of two polyhedra into the points of its contact manifold `spots`. On entry
   c->arm_a and c->arm_b lead to the centre of the first polyhedron. Returns 0 if the list is
   full. */
static int demi_persistent_points(dem_world *w, int d, demi_persistent *c, const demi_part *p,
                                  const demi_part *q, const demi_spots *spots,
                                  const demi_persistent *old, int olds) {
    const dem_vec3 base_a = c->arm_a, base_b = c->arm_b;
    const dem_real thin = DEMI_MIN(demi_part_thin(p), demi_part_thin(q));
    const int pressing = demi_response_is(w, DEMI_PRESSING);
    int k;
    c->share /= (dem_real)spots->count;
    c->corners = spots->count;
    for (k = 0; k < spots->count; k++) {
        const dem_vec3 x = demi_d3_real(spots->x[k]);
        demi_persistent *at = k ? demi_persistent_new(w, d) : c;
        if (!at) return 0;
        if (k) demi_persistent_copy(at, c);
        at->corner = k;
        at->arm_a = demi_add(base_a, x);
        at->arm_b = demi_add(base_b, x);
        at->overlap = (dem_real)-spots->gap[k];
        at->deep = at->overlap/thin;
        if (pressing) at->from = demi_persistent_same(w, d, old, olds, at);
    }
    if (!pressing) demi_persistent_nearest(w, d, old, olds, c, spots->count);
    return 1;
}
/* Appends a contact of part i of body a with part j of body b. send: as in demi_persistent. Returns
   null if the list is full. */
DEM_INLINE demi_persistent *demi_persistent_begin(dem_world *w, int d, int a, int b, int send,
                                                  int i, int j, const demi_persistent *old,
                                                  int olds) {
    demi_persistent *c = demi_persistent_new(w, d);
    if (!c) return 0;
    c->a = a; c->b = b; c->part_a = i; c->part_b = j;
    c->wall = c->element = -1;
    c->send = send;
    c->from = demi_persistent_same(w, d, old, olds, c);
    return c;
}
/* Appends the contact of two parts p and q if they touch. gap: from the centre of p to that of q,
   m. Returns 0 if the list is full. */
static int demi_persistent_parts(dem_world *w, int d, int a, int b, int send, const demi_part *p,
                                 const demi_part *q, int i, int j, dem_vec3 gap,
                                 const demi_persistent *old, int olds) {
    const demi_persistent *now = demi_persistent_of(w, d);
    demi_persistent *c = demi_persistent_begin(w, d, a, b, send, i, j, old, olds);
    demi_spots spots;
    if (!c) return 0;
    spots.count = 0;
    if (c->from >= 0) c->normal = now[c->from].normal;      /* initial guess */
    if (!demi_meet_of(p->kind, q->kind)(w, p, q, gap, c->from < 0 ? 0 : now[c->from].lambda, c,
                                        &spots))
        w->domains[d].persistent_next--;
    else if (w->flush.count && demi_flush_within(w, c, p, q, gap, &spots))
        w->domains[d].persistent_next--;
    else if (spots.count ? !demi_persistent_points(w, d, c, p, q, &spots, old, olds)
             : c->corners && !demi_persistent_spread(w, d, c, old, olds)) return 0;
    else if (w->flush.count && !spots.count) demi_flush_follow(w, c, p, q);
    return 1;
}
/* Appends the contact of two spheres of neighbouring bodies if they touch; most do not. one, other:
   their rows (centre from the body's, radius, m); to: from sphere i's centre to the centre of body
   b, m. Returns 0 if the list is full. */
DEM_INLINE int demi_persistent_two(dem_world *w, int d, int a, int b, int send, int i, int j,
                                   const dem_real *one, const dem_real *other, dem_vec3 to,
                                   const demi_persistent *old, int olds) {
    const dem_vec3 gap = demi_add(to, demi_at(other));
    const dem_real radii = one[3] + other[3];
    const dem_real near_by = w->margin.reach > 0 ? radii + demi_range(w, radii) : radii;
    demi_persistent *c;
    if (!(demi_dot(gap, gap) < near_by*near_by)) return 1;
    c = demi_persistent_begin(w, d, a, b, send, i, j, old, olds);
    if (!c) return 0;
    if (!demi_balls_meet(w, demi_at(one), one[3], demi_at(other), other[3], gap, c))
        w->domains[d].persistent_next--;
    return 1;
}
/* Lists the pairs of spheres of bodies a and b that may touch while the pruned neighbour list is
   valid. r: from a's centre to b's, m; x, na and y, nb: the rows of their spheres. It may be called
   at any step during the life of that list: bounds for its whole life cover the rest of it. */
static void demi_balls_near(const dem_world *w, int a, int b, dem_vec3 r, const dem_real *x, int na,
                            const dem_real *y, int nb, demi_near_balls *out) {
    const dem_real cut = demi_near_cut(w, a, b), far_b = demi_radius(w, b) + cut;
    int i, j;
    out->count = na > 256 || nb > 256 ? DEMI_BALLS_ALL : 0;
    for (i = 0; i < na && out->count != DEMI_BALLS_ALL; i++) {
        const dem_vec3 to = demi_sub(r, demi_at(x + 4*i));
        const dem_real all = x[4*i + 3] + far_b;
        if (na > 1 && !(demi_dot(to, to) < all*all)) continue;
        for (j = 0; j < nb; j++) {
            const dem_vec3 gap = demi_add(to, demi_at(y + 4*j));
            const dem_real near_by = x[4*i + 3] + y[4*j + 3] + cut;
            if (!(demi_dot(gap, gap) < near_by*near_by)) continue;
            if (out->count == DEMI_NEAR_BALLS) { out->count = DEMI_BALLS_ALL; break; }
            out->a[out->count] = (uint8_t)i;
            out->b[out->count++] = (uint8_t)j;
        }
    }
}
/* Appends all contacts of a candidate pair of spheres and clusters, entry `at` of the pruned
   neighbour list. r: from a's centre to b's, m; old: the contacts of body a in the step before.
   Returns 0 if the list is full. */
static int demi_persistent_balls(dem_world *w, int d, int at, int send, dem_vec3 r,
                                 const dem_real *x, int na, const dem_real *y, int nb,
                                 const demi_persistent *old, int olds) {
    const int a = w->near.a[at], b = w->near.b[at];
    const dem_real far_b = demi_radius(w, b) + (dem_real)w->margin.reach;
    demi_near_balls *some = w->near.balls + at;
    int i, j, k;
    if (some->count == DEMI_BALLS_UNKNOWN) demi_balls_near(w, a, b, r, x, na, y, nb, some);
    if (some->count != DEMI_BALLS_ALL) {
        for (k = 0; k < some->count; k++) {
            const dem_real *one = x + 4*(i = some->a[k]), *other = y + 4*(j = some->b[k]);
            if (!demi_persistent_two(w, d, a, b, send, i, j, one, other, demi_sub(r, demi_at(one)),
                                     old, olds)) return 0;
        }
        return 1;
    }
    for (i = 0; i < na; i++) {
        const dem_vec3 to = demi_sub(r, demi_at(x + 4*i));
        const dem_real all = x[4*i + 3] + far_b;
        if (na > 1 && !(demi_dot(to, to) < all*all)) continue;
        for (j = 0; j < nb; j++)
            if (!demi_persistent_two(w, d, a, b, send, i, j, x + 4*i, y + 4*j, to, old, olds))
                return 0;
    }
    return 1;
}
/* The same for bodies of any parts. */
static int demi_persistent_any(dem_world *w, int d, int a, int b, int send, dem_vec3 r,
                               const demi_persistent *old, int olds) {
    const int na = demi_parts_count(w, a), nb = demi_parts_count(w, b);
    const dem_real rb = demi_radius(w, b) + (dem_real)w->margin.reach;
    int i, j;
    for (i = 0; i < na; i++) {
        const demi_part p = demi_part_now(w, a, i);
        const dem_vec3 to = demi_sub(r, p.centre);
        if (na > 1 && !(demi_dot(to, to) < (p.radius + rb)*(p.radius + rb))) continue;
        for (j = 0; j < nb; j++) {
            const demi_part q = demi_part_now(w, b, j);
            const dem_vec3 gap = demi_add(to, q.centre);
            const dem_real near_by = p.radius + q.radius + demi_range(w, p.radius + q.radius);
            if (demi_dot(gap, gap) < near_by*near_by &&
                !demi_persistent_parts(w, d, a, b, send, &p, &q, i, j, gap, old, olds)) return 0;
        }
    }
    return 1;
}
/* Appends the contact of two ellipsoids, or of an ellipsoid and a sphere, if they touch: row k of a
   tile. It is the only contact of its pair, so all its weights are 1. */
static void demi_persistent_ellipsoids(dem_world *w, int d, demi_ellipsoid_tile *t, int k,
                                       int send) {
    const int at = d*w->near.stride + t->entry[k];
    demi_part p, q;
    demi_persistent *c;
    if (!demi_ellipsoids_meet(t, k)) return;
    c = demi_persistent_new(w, d);
    if (!c) return;
    demi_persistent_ahead(c, 2, 1);
    c->a = w->near.a[at]; c->b = w->near.b[at];
    c->wall = c->element = -1;
    c->send = send;
    c->from = t->from[k];
    c->weight = c->lift = c->grip = 1;
    c->held = -1;                               /* as demi_persistent_past for one contact */
    if (w->desc.ellipsoid_overlap != DEM_OVERLAP_CONSERVATIVE) {
        p = demi_part_now(w, c->a, 0);
        q = demi_part_now(w, c->b, 0);
    }
    demi_ellipsoids_set(w, t, k, &p, &q, c);
    c->arm_a = demi_d3_real(demi_ellipsoids_at(t->point, k));
    /* to the same point, exactly: conserves angular momentum */
    c->arm_b = demi_sub(c->arm_a,
                        demi_near_level(w, (size_t)at, demi_near_bodies_way(w, (size_t)at)));
}
/* Finds the contacts of one candidate pair, then merges them and passes grip on. */
static DEMI_APART void demi_persistent_pair(dem_world *w, int d, int at, int send,
                                            const demi_persistent *old, int olds) {
    const int a = w->near.a[at], b = w->near.b[at], first = w->domains[d].persistent_next;
    const dem_vec3 r = demi_near_level(w, (size_t)at, demi_near_bodies_way(w, (size_t)at));
    const dem_real radii = demi_radius(w, a) + demi_radius(w, b);
    const dem_real far = radii + (dem_real)w->margin.reach;
    const demi_persistent *now = demi_persistent_of(w, d);
    demi_persistent *from = w->persistent_next + w->persistent_first[d] + first;
    const dem_real *x, *y;
    int na, nb, count;
    if (!(demi_dot(r, r) < far*far)) return;
    x = demi_balls_of(w, a, &na);
    y = demi_balls_of(w, b, &nb);
    if (!(x && y ? demi_persistent_balls(w, d, at, send, r, x, na, y, nb, old, olds)
          : demi_persistent_any(w, d, a, b, send, r, old, olds))) return;
    count = w->domains[d].persistent_next - first;
    if (!count) return;
    demi_persistent_share(w, from, count);
    demi_persistent_inherit(now, from, count);
}
/* Finds the contacts of entry p of the pruned list of work group d: of ellipsoids from tile t,
   which is filled again, before `end`, when it is used up; those of others individually. */
DEM_INLINE void demi_persistent_entry(dem_world *w, int d, int p, int end, int send,
                                      demi_ellipsoid_tile *t, const demi_persistent *old,
                                      int olds) {
    if (p >= t->end) demi_ellipsoids_find(w, d, p, end, t);
    if (t->next < t->count && t->entry[t->next] == p)
        demi_persistent_ellipsoids(w, d, t, t->next++, send);
    else demi_persistent_pair(w, d, d*w->near.stride + p, send, old, olds);
}

/* Handles a body whose centre has passed through an open surface, which repels on both sides: from
   then on it pushes the body out on the far side. The normal of contact c then reverses within one
   step, and no contact with the old normal is left. The relative depth continues that of the old
   one: 2 - deep. This does not apply at the end of a surface, which repels a polyhedron on both
   sides for a while. old: contacts of the body in the step before; fresh: all its new ones with
   this wall. */
static void demi_persistent_through(const dem_world *w, const demi_persistent *old, int olds,
                                    const demi_persistent *fresh, int count, demi_persistent *c) {
    int e, i;
    for (e = 0; e < olds && c->corners; e++)
        if (old[e].b < 0 && demi_persistent_one(w, &old[e], c) && old[e].part_a == c->part_a &&
            demi_dot(old[e].normal, c->normal) > DEM_R(0.5)) return;
    for (e = 0; e < olds && c->deep < 1; e++) {
        if (old[e].b >= 0 || !demi_persistent_one(w, &old[e], c) || old[e].part_a != c->part_a ||
            old[e].deep + c->deep < 1 || demi_dot(old[e].normal, c->normal) > DEM_R(-0.5)) continue;
        for (i = 0; i < count && !(demi_dot(fresh[i].normal, old[e].normal) > 0); i++);
        if (i == count) c->deep = 2 - c->deep;
    }
}
/* True if contact point `place` of part p, whose centre is at `at`, overlaps or is within the range
   of the law. Contact points of other shapes are found only within that range. For an ellipsoid the
   gap is the distance from its surface to the point, measured on the ray from its centre. For a
   grain of a wall it is that of two ellipsoids (demi_ellipsoids_meet), measured to the grain's
   centre. */
static int demi_place_near(const dem_world *w, const demi_wall *wall, const demi_part *p,
                           dem_vec3 at, const demi_touching *place) {
    const dem_real scale = 1 - place->overlap;
    const dem_real beyond = demi_wall_is(wall, DEMI_BALLS) ? wall->radius*scale : DEM_R(0);
    const dem_vec3 to = demi_add(demi_sub(place->point, at), demi_scale(place->normal, beyond));
    return p->kind != DEMI_ELLIPSOID || place->overlap > 0 ||
        demi_length(to)*(1 - 1/scale) < demi_range(w, p->radius);
}
/* Appends the contacts of part k of a body with one wall, then decides which old one each
   continues. shaped: 0 for a sphere, for which the compiler makes a specialised copy; the weights
   of its contact points remain those that were found. */
DEM_INLINE void demi_persistent_on_wall(dem_world *w, demi_view *v, int body, int shaped, int k,
                                        const demi_part *p, const demi_persistent *old, int olds) {
    const demi_wall *wall = v->wall;
    const int d = v->d;
    const dem_vec3 at = v->at = demi_add(demi_at(w->bodies.pos + 4*body), p->centre);
    demi_touching *found = w->touching + w->domains[d].touching_first;
    const int places = demi_touches[wall->kind][p->kind](v, p, found);
    demi_persistent *fresh = 0, *c;
    int i, e, count = 0;
    for (i = 0; i < places; i++) {
        if (shaped && w->margin.reach > 0 && !demi_place_near(w, wall, p, at, &found[i])) continue;
        c = demi_persistent_new(w, d);
        if (!c) return;
        if (!count++) fresh = c;
        c->a = body;
        c->part_a = k;
        c->element = found[i].element;
        c->wall = demi_surface_wall(w, wall, c->element);
        c->normal = found[i].normal;
        c->share = c->weight = c->lift = c->grip = found[i].share;
        c->shift = found[i].shift;
        if (!shaped || p->kind == DEMI_BALL) {  /* the most common, inlined */
            demi_ball_on_wall(w, wall, p, &found[i], c);
            if (shaped && w->desc.cluster_contacts == DEM_CLUSTER_CONTACTS_MERGED && c->overlap > 0)
                demi_wall_bend(wall, v->element, v->left,
                               DEMI_MAX(p->radius - c->overlap, p->radius/10),
                               demi_add(found[i].point, c->shift), c);
        } else demi_on_walls[p->kind](w, wall, p, &found[i], c);
        /* the point of the wall, until demi_persistent_cover; points of gaps are half way */
        if (v->several)
            c->arm_b = demi_sub(found[i].point,
                                demi_scale(c->normal, c->corners ? c->overlap/2 : 0));
        c->r_eff = (dem_real)demi_wall_r_eff(wall, (double)c->r_eff);
    }
    if (shaped && count && fresh->corners && !demi_response_is(w, DEMI_PRESSING))
        demi_persistent_nearest(w, d, old, olds, fresh, count);
    else
        for (i = 0, c = fresh; i < count; i++, c++)
            c->from = !shaped || !c->corners ? demi_persistent_same(w, d, old, olds, c)
                : demi_persistent_best(w, d, old, olds, fresh, count, c, DEMI_FIT_TURNED);
    for (i = 0, c = fresh; i < count; i++, c++) {
        if (demi_persistent_later(c)) c->from = demi_persistent_part(w, d, &old[olds], c);
        else if (c->from < 0 && olds)
            c->from = demi_persistent_best(w, d, old, olds, fresh, count, c, DEMI_FIT_SLID);
        if (c->corner == 3) demi_persistent_turn(w, d, c - 3);
        if (c->deep > DEM_R(0.1) && olds) demi_persistent_through(w, old, olds, fresh, count, c);
        if (wall->sieve.kind != DEM_SIEVE_REDUCED) continue;
        for (e = 0; e < olds; e++)              /* stays in the hole until through */
            if (old[e].b < 0 && old[e].wall == c->wall && old[e].part_a == k && c->overlap > 0 &&
                !demi_persistent_asked(w, &old[e])) c->weight = c->lift = c->grip = c->share = 0;
        if (!(c->share > 0)) c->overlap = c->deep = 0;
    }
}
/* True if a sphere at `at` cannot touch the part of a wall that its body may touch. Decided only
   for planes, from which most spheres of a nearby cluster are far away; 0: must be examined. */
DEM_INLINE int demi_ball_clear(const demi_view *v, dem_vec3 at, dem_real r) {
    const dem_real *R = v->wall->pose.rotation;
    dem_vec3 x;
    if (v->wall->kind != DEMI_WALL_PLANE || v->left > 1 || v->late) return 0;
    x = demi_sub(demi_add(at, demi_at(v->from)), v->wall->pose.position);
    return R[2]*x.x + R[5]*x.y + R[8]*x.z > (r + demi_range(v->w, r))*DEM_R(1.001);
}
/* Finds all contacts of one body with one surface: candidates first .. last - 1 of work group d.
   several: 1 if other surfaces are near the body. */
static DEMI_APART void demi_persistent_wall(dem_world *w, int d, int first, int last, int several,
                                            const demi_persistent *old, int olds) {
    const int body = w->wall_body[d*w->wall_stride + first];
    const int parts = demi_parts_count(w, body);
    demi_view v = demi_view_of(w, d, first, last);
    const dem_real *balls;
    int k, count;
    v.several = several;
    if ((v.late = demi_walls_late(w, body))) v.gone = DEM_R(1e30);     /* gaps: half a step ahead */
    if (!demi_shape_of(w, body)) {
        const demi_part sphere = demi_part_now(w, body, 0);
        demi_persistent_on_wall(w, &v, body, 0, 0, &sphere, old, olds);
        return;
    }
    balls = demi_balls_of(w, body, &count);
    for (k = 0; k < parts; k++) {
        demi_part p;
        if (balls && demi_ball_clear(&v, demi_add(demi_at(w->bodies.pos + 4*body),
                                                  demi_at(balls + 4*k)), balls[4*k + 3])) continue;
        p = demi_part_now(w, body, k);
        demi_persistent_on_wall(w, &v, body, 1, k, &p, old, olds);
    }
}
/* True if two contacts of one body with walls belong to the same surface: same part, and walls at
   rest relative to each other. */
DEM_INLINE int demi_persistent_beside(const dem_world *w, const demi_persistent *a,
                                      const demi_persistent *b) {
    return a->part_a == b->part_a && w->walls[a->wall].group == w->walls[b->wall].group;
}
/* Returns the (not normalised) weight with which contact c takes part in the negative weight of
   contact e: the similarity of their normals over the squared distance of their points. It is 0 if
   the two do not belong to the same surface, and dominates if their points coincide. */
static double demi_persistent_nearness(const dem_world *w, const demi_persistent *e,
                                       const demi_persistent *c) {
    const dem_vec3 d = demi_add(demi_sub(c->arm_a, e->arm_a),
        demi_sub(demi_scale(e->normal, e->overlap), demi_scale(c->normal, c->overlap)));
    const double hair = 1e-9*(double)e->r_eff;
    dem_real rate;
    if (!(c->weight > 0) || !(c->overlap > 0) || !demi_persistent_beside(w, e, c)) return 0;
    return (double)demi_persistent_along(e, c, &rate)/((double)demi_dot(d, d) + hair*hair);
}
/* Removes the friction of contacts with negative weight (where rows of a sieve cross, or at the
   edge of a valley of facets): a sliding contact with negative friction would supply energy. The
   friction of the neighbouring contacts, springs and limits alike, is reduced by the same amount
   instead, mostly that of the nearest. A contact that is cancelled entirely has no friction. Two
   contacts that begin as one together hold what the one held. mu remains the ratio of the two total
   forces. */
static void demi_persistent_crossed(const dem_world *w, demi_persistent *c, int n) {
    const int hertz = demi_normal_is(w, DEMI_HERTZIAN);
    int i, k;
    for (k = 0; k < n; k++) {
        double all = 0;
        if (!(c[k].weight < 0)) continue;
        c[k].grip = 0;
        for (i = 0; i < n && c[k].overlap > 0; i++)
            all += demi_persistent_nearness(w, &c[k], &c[i]);
        for (i = 0; i < n && all > 0; i++) {
            const dem_real part = (dem_real)(demi_persistent_nearness(w, &c[k], &c[i])/all);
            if (part > 0)
                c[i].held += part*c[k].weight*demi_persistent_steep(&c[k], &c[i], hertz, 0);
        }
    }
    for (k = 0; k < n; k++) {                   /* held: the reduction, until it is applied */
        if (c[k].held < 0) c[k].grip *= DEMI_MAX(1 + c[k].held/c[k].weight, DEM_R(0));
        c[k].held = 0;
    }
}
/* If a contact with a surface ends at depth, because another one has replaced it, its springs pass
   to the contact with the most similar normal: that contact's `send` names the one that ended. */
static void demi_persistent_ended(const dem_world *w, int d, const demi_persistent *old, int olds,
                                  demi_persistent *c, int n) {
    const int first = (int)(old - demi_persistent_of(w, d));
    int e, i;
    for (e = 0; e < olds; e++) {
        const demi_wall *wall = old[e].b >= 0 ? 0
            : demi_surface_of(w, demi_persistent_surface(w, &old[e]));
        dem_real nearest = DEM_R(0.95);
        demi_persistent *heir = 0;
        if (!wall || !(old[e].grip > 0) || demi_persistent_later(&old[e]) ||
            !(demi_faceted(wall) || demi_wall_is(wall, DEMI_CROSSED))) continue;
        for (i = 0; i < n && c[i].from != first + e; i++) {
            const dem_real along = demi_dot(old[e].normal, c[i].normal);
            if (!(along > nearest) || c[i].from < 0 || c[i].share < 0 ||
                demi_persistent_later(&c[i]) ||
                c[i].corner != old[e].corner ||
                !(2*old[e].overlap > c[i].overlap) || !demi_persistent_beside(w, &old[e], &c[i]))
                continue;
            nearest = along;
            heir = &c[i];
        }
        if (i == n && heir && !heir->send) heir->send = 1 + first + e;
    }
    for (i = 0; i < n; i++) if (demi_persistent_later(&c[i])) c[i].send = c[i - c[i].corners].send;
}
/* True if the point of c on its wall lies on a surface, such as another one. first, last: the
   candidates of the body in work group d; level: only facets across the normal count. Planes,
   cylinders and surfaces of facets can cover others. */
static int demi_persistent_lies_on(const dem_world *w, int d, int first, int last,
                                   const demi_persistent *c, int surface, int level) {
    const demi_wall *wall = demi_surface_of(w, surface);
    const dem_vec3 n = demi_unrotate(wall->pose.rotation, c->normal);
    const dem_real close = DEM_R(1e-5)*c->r_eff + wall->plane_slack;
    int k;
    if (!demi_wall_is(wall, DEMI_FACETS | DEMI_SMOOTH) || wall->step[0].x > 0) return 0;
    for (k = d*w->wall_stride + first; k < d*w->wall_stride + last; k++) {
        dem_vec3 at = demi_add(c->arm_b, demi_at(w->wall_shift + 3*(size_t)k));
        if (demi_walls_late(w, c->a)) at = demi_add(at, demi_wall_carry(w, wall, at));
        if (level && w->wall_id[k] == surface && demi_faceted(wall) &&
            !(DEMI_ABS(demi_dot(demi_at(wall->planes + 4*w->wall_element[k]), n)) >
              DEM_R(DEMI_FLUSH))) continue;
        if (w->wall_id[k] == surface && DEMI_ABS(demi_wall_distance(wall, w->wall_element[k],
            demi_unrotate(wall->pose.rotation, demi_sub(at, wall->pose.position)), close)) < close)
            return 1;
    }
    return 0;
}
/* True if contact c is by the plane of its facet, so that it stays where surfaces abut: only points
   of polyhedra, of which a facet may have several. */
static int demi_persistent_flush(const dem_world *w, const demi_persistent *c) {
    const demi_wall *wall = demi_surface_of(w, demi_persistent_surface(w, c));
    const int32_t element = wall->scale ? c->element%wall->number_count : c->element;
    return c->corners && demi_faceted(wall) && element < wall->element_count &&
        DEMI_ABS(demi_dot(demi_at(wall->planes + 4*element),
                          demi_unrotate(wall->pose.rotation, c->normal))) > DEM_R(DEMI_FLUSH);
}
/* True if several surfaces are near a body and one of them may have edges. wall: the surfaces of
   its candidates. */
DEM_INLINE int demi_persistent_several(const dem_world *w, const int32_t *wall, int count) {
    int i, edges = 0;
    for (i = 0; i < count && wall[0] != wall[count - 1]; i++)
        edges |= !demi_wall_is(demi_surface_of(w, wall[i]), DEMI_SMOOTH);
    return edges;
}
/* Removes contacts at edges of surfaces that move against each other and abut, such as belts in a
   floor: where the point of a contact lies on another surface that the body touches too, that
   surface covers the edge. Of contacts that lie on each other's surface, one on a face covers one
   on an edge; of two on faces or on edges the first remains. walled: the first contact of the body
   with walls. */
static void demi_persistent_cover(dem_world *w, int d, int first, int last, int walled) {
    demi_persistent *c = w->persistent_next + w->persistent_first[d];
    const int all = w->domains[d].persistent_next, pressing = demi_response_is(w, DEMI_PRESSING);
    int i, k, left = walled;
    for (i = walled; i < all; i++) {
        const int own = demi_persistent_surface(w, &c[i]);
        int covered = 0, level;
        if (demi_persistent_flush(w, &c[i]) || (pressing && c[i].corners)) continue;
        for (k = walled; k < all && !covered; k++) {
            const int other = demi_persistent_surface(w, &c[k]);
            if (other == own || c[k].part_a != c[i].part_a || c[k].a < 0) continue;
            if (!demi_persistent_lies_on(w, d, first, last, &c[i], other, 0)) continue;
            covered = demi_persistent_flush(w, &c[k]) ||
                !demi_persistent_lies_on(w, d, first, last, &c[k], own, 0);
            if (covered) continue;
            level = demi_persistent_lies_on(w, d, first, last, &c[i], own, 1);
            covered = level == demi_persistent_lies_on(w, d, first, last, &c[k], other, 1)
                ? k < i : !level;
        }
        if (covered) c[i].a = -1;               /* it leaves the list below */
    }
    for (i = walled; i < all; i++) {
        if (c[i].a < 0) continue;
        c[i].arm_b = demi_v(0, 0, 0);
        if (i > left) demi_persistent_copy(&c[left], &c[i]);
        left++;
    }
    w->domains[d].persistent_next = left;
}
/* Completes the contacts of one body with walls once all are found: the weights of friction, and
   which springs of the step before each inherits. */
static void demi_persistent_settle(const dem_world *w, int d, const demi_persistent *old, int olds,
                                   demi_persistent *c, int n) {
    const demi_persistent *now = demi_persistent_of(w, d);
    if (n == 1 && olds <= 1) { c->held = -1; return; }      /* do not load the old one yet */
    demi_persistent_crossed(w, c, n);
    demi_persistent_ended(w, d, old, olds, c, n);
    demi_persistent_inherit(now, c, n);
}

/* Finds all persistent contacts of one work group in the order of body a. Each body has its pairs
   within the group first, then its pairs with other groups, then its walls. */
static void demi_domain_persistent_touch(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    const demi_persistent *old = demi_persistent_of(w, d), *old_end;
    const demi_persistent *end = old + domain->persistent;
    const int32_t *near_a = w->near.a + d*w->near.stride;
    const int32_t *body = w->wall_body + d*w->wall_stride, *wall = w->wall_id + d*w->wall_stride;
    const dem_real *gap = w->wall_gap + d*w->wall_stride;
    const dem_real gone = demi_some_late(w, d) ? DEM_R(1e30) : demi_walls_gone(w);
    const int base = d*w->near.stride, walls = domain->walls;
    const int own_end = domain->near_shaped_cross, cross_end = domain->near_shaped_end;
    int p = domain->near_shaped, q = own_end, k = 0, a, last, walled, several;
    int from, end_k;
    const int ellipsoids = demi_ellipsoids_exist(w);
    demi_ellipsoid_tile own, cross;
    own.end = cross.end = ellipsoids ? 0 : INT_MAX;
    own.next = own.count = cross.next = cross.count = 0;
    own.old = cross.old = old;
    own.of = cross.of = -1;
    domain->persistent_next = domain->persistent_same = 0;
    domain->overflow &= ~16;
    if (w->effects.clustered || (w->effects.unlike && demi_response_is(w, DEMI_LAWS)))
        demi_balls_place(w, domain->begin, domain->end);
    for (; !(domain->overflow & 16); old = old_end) {
        while (k < walls && gap[k] > gone) k++; /* not close enough yet */
        a = k < walls ? body[k] : INT_MAX;
        if (p < own_end) a = DEMI_MIN(a, near_a[p]);
        if (q < cross_end) a = DEMI_MIN(a, near_a[q]);
        if (a == INT_MAX) return;
        while (old < end && old->a < a) old++;
        for (old_end = old; old_end < end && old_end->a == a;) old_end++;
        if (old_end + 1 < end) DEMI_FETCH(old_end + 1);     /* hardware does not prefetch this */
        if (k + DEMI_LANES < walls) DEMI_FETCH(w->bodies.pos + 4*body[k + DEMI_LANES]);
        for (; p < own_end && near_a[p] == a; p++)
            demi_persistent_entry(w, d, p, own_end, 0, &own, old, (int)(old_end - old));
        for (; q < cross_end && near_a[q] == a; q++)
            demi_persistent_entry(w, d, q, cross_end, 1 + w->near.k[base + q], &cross, old,
                                  (int)(old_end - old));
        walled = domain->persistent_next;
        for (from = end_k = k; end_k < walls && body[end_k] == a;) end_k++;
        several = from < end_k && demi_persistent_several(w, wall + from, end_k - from);
        for (; k < end_k; k = last) {
            last = k + 1;
            if (gap[k] > gone) continue;
            while (last < end_k && wall[last] == wall[k]) last++;
            demi_persistent_wall(w, d, k, last, several, old, (int)(old_end - old));
        }
        if (several && domain->persistent_next > walled)
            demi_persistent_cover(w, d, from, end_k, walled);
        if (domain->persistent_next > walled) {
            demi_persistent *c = w->persistent_next + w->persistent_first[d] + walled;
            const int n = domain->persistent_next - walled;
            if (demi_shape_of(w, a)) demi_persistent_share(w, c, n);
            demi_persistent_settle(w, d, old, (int)(old_end - old), c, n);
        }
    }
}
/* Enlarges the lists of work groups that overflowed. Returns 0 if memory ran out; nothing has
   changed then. */
static int demi_persistent_widen(dem_world *w) {
    int first[DEMI_DOMAINS + 1], d;
    for (d = 0, first[0] = 0; d < DEMI_DOMAINS; d++) {
        const int had = w->persistent_first[d + 1] - w->persistent_first[d];
        const int more = d < w->domain_count && w->domains[d].overflow & 16 ? had/2 + 64 : 0;
        first[d + 1] = first[d] + had + more;
    }
    if (!DEMI_GROW(w, w->persistent_next, (size_t)first[DEMI_DOMAINS]) ||
        !DEMI_GROW(w, w->persistent_now, (size_t)first[DEMI_DOMAINS]) ||
        !DEMI_GROW(w, w->coefs, 2*(size_t)first[DEMI_DOMAINS])) return 0;
    for (d = w->domain_count - 1; d > 0; d--)
        memmove(w->persistent_now + first[d], demi_persistent_of(w, d),
                (size_t)w->domains[d].persistent*sizeof(demi_persistent));
    memcpy(w->persistent_first, first, sizeof w->persistent_first);
    for (d = 0; d < w->domain_count; d++) w->domains[d].coefs = 0;
    return 1;
}
/* Finds the persistent contacts of all work groups. Returns 0 if memory ran out. */
static int demi_touch(dem_world *w) {
    int d, again;
    w->margin.seen = demi_foreseen(w);
    for (d = 0; d < w->domain_count; d++) w->domains[d].persistent_next = 0;
    if (!w->wall_count && !w->bodies.shaped && !w->effects.clustered) return 1;
    if ((!w->facets_valid && !demi_surfaces_make(w)) ||
        (!w->touching_valid && !demi_touching_reserve(w)) ||
        (!w->flush.valid && !demi_flush_make(w))) return 0;
    demi_surfaces_follow(w);
    do {
        demi_domains_do(w, demi_domain_persistent_touch);
        for (d = 0, again = 0; d < w->domain_count; d++) again |= w->domains[d].overflow & 16;
        if (again && !demi_persistent_widen(w)) return 0;
    } while (again);
    return 1;
}
/* Sets what a contact does not use, and its row of coefficients, to 0, since files and messages
   contain all of it. */
static void demi_persistent_tidy(const dem_world *w, demi_persistent *c) {
    int e;
    c->row = 0;
    for (e = w->memory_stride; e < DEMI_MEMORY; e++) c->memory[e] = 0;
    if (!c->odd) memset(&c->more, 0, sizeof c->more);
}
