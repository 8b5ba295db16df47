/* ---------------------------------------------------------------------------------------------
   >>kept
   Contacts that are kept by themselves: all but those of sphere and sphere (>>respond). Two bodies
   may touch in several places and each may push past the centre; a wall is touched in as many
   places as it has surfaces near: so these contacts are kept one by one. touch finds them (parts
   against parts by >>meets, against wall elements) and which of the step before each continues;
   >>kept-respond takes memory over from that one, asks the law and pushes. Within a domain they
   stand in the order of their body a. Touch may run out of room; it then begins anew with more,
   nothing lost.
   --------------------------------------------------------------------------------------------- */

/* Is the law asked about a contact? Not where the two are apart, but for a law with a range, nor
   under way through a reduced hole. */
DEM_INLINE int demi_kept_asked(const dem_world *w, const demi_kept *c) {
    return c->overlap > 0 || (w->margin.reach > 0 && (c->weight < 0 || c->weight > 0));
}
/* One contact as touch finds it. */
static demi_kept *demi_kept_new(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    demi_kept *c;
    if (domain->kept_next >= w->kept_first[d + 1] - w->kept_first[d]) {
        domain->overflow |= 16;
        return 0;
    }
    c = w->kept_next + w->kept_first[d] + domain->kept_next++;
    memset(c, 0, offsetof(demi_kept, coef));
    c->b = -1;
    c->share = c->slope = c->inset = 1;
    return c;
}

/* --- which contact of a step ago a new one continues: its number in its domain, or -1. old: the
       contacts that body a had. --- */

/* The one with the same partner and parts, or with the same wall, part, element and corner. */
DEM_INLINE int demi_kept_same(const dem_world *w, int d, const demi_kept *old, int olds,
                              const demi_kept *c) {
    const int first = (int)(old - demi_kept_of(w, d));
    int *next = &w->domains[d].kept_same, n, i = *next - first;
    if (i < 0 || i >= olds) i = 0;              /* mostly it is the one after the last */
    for (n = 0; n < olds; n++) {
        if (old[i].element == c->element && old[i].wall == c->wall &&
            old[i].part_a == c->part_a && old[i].b == c->b && old[i].part_b == c->part_b &&
            old[i].corner == c->corner) {
            *next = first + i + 1;
            return first + i;
        }
        if (++i == olds) i = 0;
    }
    return -1;
}
/* Where that is not enough, the one that fits best:
       TURNED   a polyhedron on a wall, by springs: of its element and corner the nearest normal
                within 45 degrees, since round walls, wires and holes are one element on all sides
       NEAREST  polyhedra by impulses: of the same pair or wall and within about 18 degrees the
                nearest point that no contact before this one continues
       SLID     on a wall, where nothing else fits: the body slid on to a neighbouring element */
enum demi_fit { DEMI_FIT_TURNED, DEMI_FIT_NEAREST, DEMI_FIT_SLID };
/* How well old contact o, number `from`, fits c, which slid on: by their normals; where those are
   nearly the same (within some 3 degrees), rather one that nothing continues yet; then the same
   wall, and the same sign of what they count. A place of a surface that begins at depth has split
   off another one, and takes a copy of its memory: as often as two come, one that takes away comes
   with them (>>facets). Walls that do not move against each other are one here. */
static dem_real demi_kept_slid(const dem_world *w, const demi_kept *o, int from,
                               const demi_kept *fresh, int freshs, const demi_kept *c) {
    const dem_real hair = DEMI_SINGLE ? DEM_R(1e-5) : DEM_R(1e-10);
    const demi_wall *wall = &w->walls[c->wall];
    const int crossed = demi_wall_is(wall, DEMI_CROSSED), faceted = demi_faceted(wall);
    const int alike = (o->weight < 0) == (c->share < 0);
    int j, taken = 0;
    if (w->walls[o->wall].group != wall->group || ((crossed || !(c->share < 0)) && !alike))
        return DEMI_FAR_OFF;
    for (j = 0; j < freshs && !taken; j++)
        taken = fresh[j].wall == o->wall && fresh[j].element == o->element;
    for (j = 0; j < freshs && !taken && !faceted; j++) {        /* one alone may: the nearest */
        const dem_real nearer = demi_dot(o->normal, demi_sub(fresh[j].normal, c->normal));
        taken = fresh + j != c && (!crossed || (fresh[j].share < 0) == (c->share < 0)) &&
            (fresh[j].from == from || (fresh[j].from < 0 &&
             (nearer > 0 || (!(nearer < 0) && fresh + j < c))));
    }
    if (taken && (!faceted || !(2*c->overlap > o->overlap))) return DEMI_FAR_OFF;
    return demi_dot(o->normal, c->normal) + (taken ? 0 : DEM_R(1e-3)) +
        (o->wall == c->wall ? hair : 0) + (alike ? 2*hair : 0);
}
/* fresh: all new contacts of the pair, or with the wall; NEAREST: those up to c. */
static int demi_kept_best(const dem_world *w, int d, const demi_kept *old, int olds,
                          const demi_kept *fresh, int freshs, const demi_kept *c,
                          enum demi_fit how) {
    const int first = (int)(old - demi_kept_of(w, d));
    dem_real most = DEMI_FAR_OFF;
    int i, best = -1;
    for (i = 0; i < olds; i++) {
        const demi_kept *o = &old[i], *f = fresh;
        dem_real fit = demi_dot(o->normal, c->normal);
        if (!(fit > (how == DEMI_FIT_TURNED ? DEM_R(0.7) : DEM_R(0.95))) || o->b != c->b ||
            o->part_a != c->part_a || o->part_b != c->part_b ||
            (o->wall != c->wall && how != DEMI_FIT_SLID) ||
            (o->corner != c->corner && how != DEMI_FIT_NEAREST) ||
            (o->element != c->element && how == DEMI_FIT_TURNED)) continue;
        if (how == DEMI_FIT_SLID) fit = demi_kept_slid(w, o, first + i, fresh, freshs, c);
        if (how == DEMI_FIT_NEAREST) {
            const dem_vec3 way = demi_sub(o->arm_a, c->arm_a);
            while (f < c && f->from != first + i) f++;
            fit = f < c ? DEMI_FAR_OFF : -demi_dot(way, way);
        }
        if (!(fit > most)) continue;
        most = fit;
        best = first + i;
    }
    return best;
}
/* How far two contacts of one pair push the same way, t: 1 within 25 degrees, 0 beyond 45. *rate:
   how t changes with the cosine between their normals. Those of one part are not shared: they are
   counted already, by what they weigh. */
DEM_INLINE dem_real demi_kept_along(const demi_kept *a, const demi_kept *b, dem_real *rate) {
    const dem_real zero = DEM_R(0.7071067811865476), one = DEM_R(0.9063077870366499);
    const dem_real t = (demi_dot(a->normal, b->normal) - zero)/(one - zero);
    *rate = t > 0 && t < 1 ? 6*t*(1 - t)/(one - zero) : 0;
    return !(t > 0) ? 0 : t < 1 ? t*t*(3 - 2*t) : 1;
}
DEM_INLINE dem_real demi_kept_alike(const demi_kept *a, const demi_kept *b, dem_real *rate) {
    *rate = 0;
    return a->part_a == b->part_a && a->part_b == b->part_b ? 0 : demi_kept_along(a, b, rate);
}
/* The force aside on contact c's ball that has c's normal turn towards, or away from, another's:
   -(dE/dt)(dt/dcos) d(n.other)/dx. push: the first two. */
DEM_INLINE void demi_kept_aside(demi_kept *c, dem_vec3 other, dem_real push) {
    const dem_real along = demi_dot(other, c->axis);
    dem_vec3 turn = demi_sub(other, demi_scale(c->normal, demi_dot(other, c->normal)));
    turn = demi_sub(turn, demi_scale(c->axis, along));
    turn = demi_add(demi_scale(turn, c->bend), demi_scale(c->axis, along*c->along));
    c->aside = demi_add(c->aside, demi_scale(turn, push));
}
/* Exponent of R* in the stiffness of a body's contacts: 1/2 for Hertz; linear: 2/5, or 0 where the
   stiffness is given. */
static dem_real demi_kept_power(const dem_world *w, const demi_kept *c) {
    const int a = w->bodies.material[c->a] - 1;
    const int b = c->b < 0 ? w->walls[c->wall].material : w->bodies.material[c->b] - 1;
    if (demi_normal_is(w, DEMI_HERTZIAN)) return DEM_R(0.5);
    return w->pairs[a*DEMI_MATERIALS + b].given.stiffness > 0 ? DEM_R(0) : DEM_R(0.4);
}
/* U'(d_i) over U'(d_k), of contacts that overlap: q, exponent of R*, as above. */
static dem_real demi_kept_steep(const demi_kept *i, const demi_kept *k, int hertz, dem_real q) {
    const dem_real more = i->overlap/k->overlap, R = i->r_eff/k->r_eff;
    if (hertz) return more*DEMI_SQRT(more*R);
    return q > 0 && (R < 1 || R > 1) ? more*(dem_real)demi_pow((double)R, (double)q) : more;
}
/* What the shared energy (below) asks of contacts whose shares are known: lift, aside, grip. */
static void demi_kept_lift(const dem_world *w, demi_kept *c, int n) {
    const int hertz = demi_normal_is(w, DEMI_HERTZIAN);
    const dem_real p = hertz ? DEM_R(2.5) : DEM_R(2), q = demi_kept_power(w, c);
    dem_real rate;
    int i, k;
    for (k = 0; k < n; k++) {
        const dem_real d = c[k].overlap, own = c[k].share*d/p;     /* E_k over U'(d_k) */
        if (!(d > 0)) continue;
        c[k].lift = c[k].share*(1 + 2/p*c[k].rate*c[k].added*d*d/c[k].area);
        for (i = 0; i < n; i++) {
            const dem_real t = i == k ? 0 : demi_kept_alike(&c[i], &c[k], &rate);
            const dem_real e = c[i].overlap;
            dem_real far;                       /* E_i over U'(d_k) and A_i */
            if (!(t > 0) || !(e > 0)) continue;
            far = demi_kept_steep(&c[i], &c[k], hertz, q)*c[i].share*e/p*c[i].rate/c[i].area;
            c[k].lift -= far*2*t*c[k].weight*d;
            if (rate > 0)
                demi_kept_aside(&c[k], c[i].normal, rate*(far*c[k].weight*d*d +
                                  own*c[k].rate/c[k].area*c[i].weight*e*e));
        }
    }
    for (k = 0; k < n; k++) {
        dem_real lift = 0, share = 0, own = 0;
        if (!(c[k].overlap > 0)) continue;
        for (i = 0; i < n; i++) {
            const dem_real t = i == k ? 1 : demi_kept_along(&c[i], &c[k], &rate);
            dem_real press;                     /* U'(d_i) over U'(d_k) */
            if (!(t > 0) || !(c[i].overlap > 0)) continue;
            press = t*demi_kept_steep(&c[i], &c[k], hertz, q);
            lift += press*c[i].lift;
            share += press*c[i].share;
            if (i == k) own = press;
        }
        if (share > DEM_R(0.1)*own && lift > 0) c[k].grip = c[k].share*lift/share;
        else c[k].grip = c[k].share;
    }
}
/* Room that contact i leaves to itself: 1 + x, x what the others add, over d_i^2; where others take
   away (>>facets) smoothly no less than a quarter. *rate: how it changes with x. */
static dem_real demi_kept_room_of(dem_real x, dem_real *rate) {
    const dem_real below = DEM_R(0.0625)/(DEM_R(-0.25) - x);    /* x < -1/2 */
    *rate = x < DEM_R(-0.5) ? 16*below*below : DEM_R(1);
    return x < DEM_R(-0.5) ? DEM_R(0.25) + below : 1 + x;
}
static int demi_is_cluster(const dem_world *w, int body) {
    const demi_shape *shape = demi_shape_of(w, body);
    return shape && shape->count;
}
/* Contacts of one pair (or of a body and a wall), c[0] .. c[n - 1], that are one in all. With
   overlaps d, weights w (>>facets; else 1), what each stores U(d), and t: do i and j push the same
   way,
       A_i = d_i^2 + sum of t_ij w_j d_j^2, j not i;   s_i = w_i d_i^2/A_i;   E = sum of s_i U(d_i)
   a mean in which the deep ones count more: alike ones store what one would, whatever their number,
   and one that begins or ends counts nothing: stiffness, damping and restitution do not grow with
   the number of spheres that happen to touch [BER23]. The elastic force is the gradient of E, which
   conserves: of contact k, along its normal, dE/dd_k = lift_k U'(d_k); and across it, as far as its
   normal turns with its place, that of the t. With U ~ sqrt(R) d^p (Hertz) or d^p
       E_i = s_i U'(d_i) d_i/p,          dE_k/dd_k = s_k U'(d_k) (1 + 2/p (A_k - d_k^2)/A_k)
       dE_i/dd_k = -E_i 2 t_ik w_k d_k/A_i,    dE_i/dt_ik = -E_i w_k d_k^2/A_i
   (Left out: how the normal of an ellipsoid, or at an edge of a polyhedron, turns at a cluster's
   ball. A ball that is nearly at what it goes round, within a tenth of its radius, turns no faster
   than there. Pieces of unions share nothing: their energies add.)
   It may be a little below 0 where others are far deeper: no mean that does not depend on their
   number can do without. What a law is asked about before it touches counts by itself. Damping goes
   by s, and feels the mass at their common middle; friction by s times (sum of lift U' over sum of
   s U'), so that mu is the ratio of both sums. Checked by "a cluster landing on one, two or
   three spheres" and tests/surface/test_facets.c. */
static void demi_kept_share(const dem_world *w, demi_kept *c, int n) {
    const int one = n > 1 && w->desc.cluster_contacts == DEM_CLUSTER_CONTACTS_MERGED &&
        (demi_is_cluster(w, c->a) || (c->b >= 0 && demi_is_cluster(w, c->b)));
    int i, j;
    for (i = 0; i < n; i++) {
        const dem_real d2 = c[i].overlap*c[i].overlap;
        dem_vec3 mean;                          /* arm of a to the common middle, times A */
        dem_real A = d2, rate;
        c[i].weight = c[i].lift = c[i].grip = c[i].share;
        c[i].felt = c[i].spread;                /* polyhedra: at the pressure's middle */
        if (!one || !(c[i].overlap > 0)) continue;
        mean = demi_scale(demi_sub(c[i].arm_a, c[i].spread), d2);
        for (j = 0; j < n; j++) {
            const dem_real t = j == i ? 0 : demi_kept_alike(&c[i], &c[j], &rate);
            const dem_real add = t*c[j].overlap*c[j].overlap*(j < i ? c[j].weight : c[j].share);
            if (!(t > 0) || !(c[j].overlap > 0)) continue;
            A += add;
            mean = demi_add(mean, demi_scale(demi_sub(c[j].arm_a, c[j].spread), add));
        }
        c[i].added = A/d2 - 1;
        c[i].area = d2*demi_kept_room_of(c[i].added, &c[i].rate);
        c[i].share = c[i].weight*d2/c[i].area;
        if (A > d2/2)                           /* else others take away: its own place will do */
            c[i].felt = demi_sub(c[i].arm_a, demi_scale(mean, 1/A));
    }
    if (one) demi_kept_lift(w, c, n);
}

/* What grip of a step ago comes to each of some contacts that are one body's with one other or with
   one wall: of those that continue the same one each its part. now: all of a step ago. */
static void demi_kept_inherit(const demi_kept *now, demi_kept *c, int n) {
    int i, k;
    for (k = 0; k < n; k++) {
        dem_real all = 0;
        if (c[k].from < 0) continue;
        for (i = 0; i < n; i++) if (c[i].from == c[k].from) all += c[i].grip;
        c[k].held = now[c[k].from].grip;
        if (all > c[k].grip) c[k].held *= c[k].grip/all;
    }
}
/* A contact of polyhedra, as touch has found it, becomes the corners that its pressure is spread
   over: spread and aside are the two directions. 0: no room. */
static int demi_kept_spread(dem_world *w, int d, demi_kept *c, const demi_kept *old, int olds) {
    const dem_vec3 one = c->spread, two = c->aside;
    int k;
    c->aside = demi_v(0, 0, 0);
    c->share /= (dem_real)c->corners;
    for (k = c->corners - 1; k >= 0; k--) {
        demi_kept *at = k ? demi_kept_new(w, d) : c;
        if (!at) return 0;
        if (k) memcpy(at, c, offsetof(demi_kept, coef));
        at->corner = k;
        if (k) at->from = demi_kept_same(w, d, old, olds, at);
        at->spread = demi_add(demi_scale(one, k & 2 ? DEM_R(-1) : DEM_R(1)),
                              demi_scale(two, k & 1 ? DEM_R(-1) : DEM_R(1)));
        if (k) {
            at->arm_a = demi_add(c->arm_a, at->spread);
            at->arm_b = demi_add(c->arm_b, at->spread);
        }
    }
    c->arm_a = demi_add(c->arm_a, c->spread);
    c->arm_b = demi_add(c->arm_b, c->spread);
    return 1;
}
/* A contact of polyhedra by its points: arm_a and arm_b are to the first one's centre. 0: no room.
   */
static int demi_kept_points(dem_world *w, int d, demi_kept *c, const demi_part *p,
                            const demi_part *q, const demi_spots *spots, const demi_kept *old,
                            int olds) {
    const dem_vec3 base_a = c->arm_a, base_b = c->arm_b;
    const dem_real thin = DEMI_MIN(demi_part_thin(p), demi_part_thin(q));
    int k;
    c->share /= (dem_real)spots->count;
    c->corners = spots->count;
    for (k = 0; k < spots->count; k++) {
        const dem_vec3 x = demi_d3_real(spots->x[k]);
        demi_kept *at = k ? demi_kept_new(w, d) : c;
        if (!at) return 0;
        if (k) memcpy(at, c, offsetof(demi_kept, coef));
        at->corner = k;
        at->arm_a = demi_add(base_a, x);
        at->arm_b = demi_add(base_b, x);
        at->overlap = (dem_real)-spots->gap[k];
        at->deep = at->overlap/thin;
        at->from = demi_response_is(w, DEMI_PRESSING)
            ? demi_kept_same(w, d, old, olds, at)
            : demi_kept_best(w, d, old, olds, c, k + 1, at, DEMI_FIT_NEAREST);
    }
    return 1;
}
/* A contact of parts i of a and j of b as it begins; null: no room. */
DEM_INLINE demi_kept *demi_kept_begin(dem_world *w, int d, int a, int b, int send, int i, int j,
                                      const demi_kept *old, int olds) {
    demi_kept *c = demi_kept_new(w, d);
    if (!c) return 0;
    c->a = a; c->b = b; c->part_a = i; c->part_b = j;
    c->wall = c->element = -1;
    c->send = send;
    c->from = demi_kept_same(w, d, old, olds, c);
    return c;
}
/* The contact of two parts, if they touch: all that touch finds of it. 0: no room. */
static int demi_kept_parts(dem_world *w, int d, int a, int b, int send, const demi_part *p,
                           const demi_part *q, int i, int j, dem_vec3 gap, const demi_kept *old,
                           int olds) {
    const demi_kept *now = demi_kept_of(w, d);
    demi_kept *c = demi_kept_begin(w, d, a, b, send, i, j, old, olds);
    demi_spots spots;
    if (!c) return 0;
    spots.count = 0;
    if (c->from >= 0) c->normal = now[c->from].normal;      /* where to begin */
    if (!demi_meet_of(p->kind, q->kind)(w, p, q, gap, c->from < 0 ? 0 : now[c->from].lambda, c,
                                        &spots))
        w->domains[d].kept_next--;
    else if (spots.count ? !demi_kept_points(w, d, c, p, q, &spots, old, olds)
             : c->corners && !demi_kept_spread(w, d, c, old, olds)) return 0;
    return 1;
}
/* Two spheres of near bodies, from their rows; to: from that of a to b's centre. Most do not touch.
   0: no room. */
DEM_INLINE int demi_kept_two(dem_world *w, int d, int a, int b, int send, int i, int j,
                             const dem_real *one, const dem_real *other, dem_vec3 to,
                             const demi_kept *old, int olds) {
    const dem_vec3 gap = demi_add(to, demi_at(other));
    const dem_real radii = one[3] + other[3];
    const dem_real near_by = w->margin.reach > 0 ? radii + demi_range(w, radii) : radii;
    demi_kept *c;
    if (!(demi_dot(gap, gap) < near_by*near_by)) return 1;
    c = demi_kept_begin(w, d, a, b, send, i, j, old, olds);
    if (!c) return 0;
    if (!demi_balls_meet(w, demi_at(one), one[3], demi_at(other), other[3], gap, c))
        w->domains[d].kept_next--;
    return 1;
}
/* Which spheres of two bodies may touch while the near list lasts; it may be asked in any step of
   its life: bounds that hold from then on outlast it. */
static void demi_balls_near(const dem_world *w, int a, int b, dem_vec3 r, const dem_real *x, int na,
                            const dem_real *y, int nb, demi_near_balls *out) {
    const dem_real cut = demi_near_cut(w, a, b), far_b = w->bodies.pos[4*b + 3] + cut;
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
/* All contacts of one near pair. r: from a's centre to b's; old: those body a had in the step
   before. 0: no room. */
static int demi_kept_balls(dem_world *w, int d, int at, int send, dem_vec3 r, const dem_real *x,
                           int na, const dem_real *y, int nb, const demi_kept *old, int olds) {
    const int a = w->near.a[at], b = w->near.b[at];
    const dem_real far_b = w->bodies.pos[4*b + 3] + (dem_real)w->margin.reach;
    demi_near_balls *some = w->near.balls + at;
    int i, j, k;
    if (some->count == DEMI_BALLS_UNKNOWN) demi_balls_near(w, a, b, r, x, na, y, nb, some);
    if (some->count != DEMI_BALLS_ALL) {
        for (k = 0; k < some->count; k++) {
            const dem_real *one = x + 4*(i = some->a[k]), *other = y + 4*(j = some->b[k]);
            if (!demi_kept_two(w, d, a, b, send, i, j, one, other, demi_sub(r, demi_at(one)), old,
                               olds)) return 0;
        }
        return 1;
    }
    for (i = 0; i < na; i++) {
        const dem_vec3 to = demi_sub(r, demi_at(x + 4*i));
        const dem_real all = x[4*i + 3] + far_b;
        if (na > 1 && !(demi_dot(to, to) < all*all)) continue;
        for (j = 0; j < nb; j++)
            if (!demi_kept_two(w, d, a, b, send, i, j, x + 4*i, y + 4*j, to, old, olds)) return 0;
    }
    return 1;
}
/* The same of bodies of any parts. */
static int demi_kept_any(dem_world *w, int d, int a, int b, int send, dem_vec3 r,
                         const demi_kept *old, int olds) {
    const int na = demi_parts_count(w, a), nb = demi_parts_count(w, b);
    const dem_real rb = w->bodies.pos[4*b + 3] + (dem_real)w->margin.reach;
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
                !demi_kept_parts(w, d, a, b, send, &p, &q, i, j, gap, old, olds)) return 0;
        }
    }
    return 1;
}
static DEMI_APART void demi_kept_pair(dem_world *w, int d, int at, int send,
                                      const demi_kept *old, int olds) {
    const int a = w->near.a[at], b = w->near.b[at], first = w->domains[d].kept_next;
    const dem_vec3 r = demi_near_way(w, (size_t)at);
    const dem_real radii = w->bodies.pos[4*a + 3] + w->bodies.pos[4*b + 3];
    const dem_real far = radii + (dem_real)w->margin.reach;
    const demi_kept *now = demi_kept_of(w, d);
    demi_kept *from = w->kept_next + w->kept_first[d] + first;
    dem_real lone[2][4];
    const dem_real *x, *y;
    int na, nb, count;
    if (!(demi_dot(r, r) < far*far)) return;
    x = demi_balls_of(w, a, lone[0], &na);
    y = demi_balls_of(w, b, lone[1], &nb);
    if (!(x && y ? demi_kept_balls(w, d, at, send, r, x, na, y, nb, old, olds)
          : demi_kept_any(w, d, a, b, send, r, old, olds))) return;
    count = w->domains[d].kept_next - first;
    if (!count) return;
    demi_kept_share(w, from, count);
    demi_kept_inherit(now, from, count);
}

/* --- overlap, arm and radius of a part's contact with a wall at a place that was found --- */
typedef void (*demi_on_wall_fn)(const dem_world *w, const demi_wall *wall, const demi_part *p,
                                const demi_touching *place, demi_kept *c);
DEM_INLINE void demi_ball_on_wall(const dem_world *w, const demi_wall *wall, const demi_part *p,
                                  const demi_touching *place, demi_kept *c) {
    (void)w; (void)wall;
    c->overlap = place->overlap;
    c->deep = c->overlap/p->radius;
    c->r_eff = p->radius;
    c->arm_a = demi_add(p->centre, demi_scale(c->normal, p->radius));
}
/* An ellipsoid's, whose place has 1 - W0 for an overlap. */
static void demi_ellipsoid_on_wall(const dem_world *w, const demi_wall *wall, const demi_part *p,
                                   const demi_touching *place, demi_kept *c) {
    demi_egg_overlap(w, p, place->overlap, demi_wall_is(wall, DEMI_BALLS) ? wall->radius : DEM_R(0),
                     c);
}
/* A polyhedron's, or of what it is nearest to in a wall of grains, whose radius is R* then. */
static void demi_polyhedron_on_wall(const dem_world *w, const demi_wall *wall, const demi_part *p,
                                    const demi_touching *place, demi_kept *c) {
    const int ball = demi_wall_is(wall, DEMI_BALLS);
    c->overlap = place->overlap;
    c->deep = place->deep;
    c->slope = place->slope;
    c->couple = place->couple;
    c->spread = place->spread;
    c->corner = place->corner;
    c->corners = place->corners;
    c->r_eff = ball ? DEM_R(1e30) : (dem_real)demi_part_equal(p);
    c->arm_a = demi_sub(place->point, demi_at(w->bodies.pos + 4*c->a));
}
#define DEMI_SHAPE_ON_WALL(KIND, NAME, WORD, GAP, TOUCH) demi_##NAME##_on_wall,
static const demi_on_wall_fn demi_on_walls[] = {DEMI_SHAPES(DEMI_SHAPE_ON_WALL)};
/* R* of a part of radius r with a wall. On a round wire the two radii of the contact differ, r and
   r q/(r + q): their geometric mean gives a force 1.5 % below that of Hertz's ellipse for a wire as
   thick as the grain, 7 % for one of a fifth. */
static double demi_wall_r_eff(const demi_wall *wall, double r) {
    const double q = (double)wall->sieve.bar/2;
    if (demi_wall_is(wall, DEMI_BALLS)) return r*(double)wall->radius/(r + (double)wall->radius);
    return demi_sieve_wires(&wall->sieve) ? r*sqrt(q/(r + q)) : r;
}
/* A sheet, which pushes to both sides, pushes a body on once its centre is through. Then contact c
   has turned round within a step, and nothing is left of the one before: its overlap is what is
   seen from there. Not at the end of a sheet, where a polyhedron is pushed to both sides for a
   while. old: those the body had; fresh: all it has with this wall now. */
static void demi_kept_through(const demi_kept *old, int olds, const demi_kept *fresh, int count,
                              demi_kept *c) {
    int e, i;
    for (e = 0; e < olds && c->corners; e++)
        if (old[e].b < 0 && old[e].wall == c->wall && old[e].part_a == c->part_a &&
            demi_dot(old[e].normal, c->normal) > DEM_R(0.5)) return;
    for (e = 0; e < olds && c->deep < 1; e++) {
        if (old[e].b >= 0 || old[e].wall != c->wall || old[e].part_a != c->part_a ||
            old[e].deep + c->deep < 1 || demi_dot(old[e].normal, c->normal) > DEM_R(-0.5))
            continue;
        for (i = 0; i < count && !(demi_dot(fresh[i].normal, old[e].normal) > 0); i++);
        if (i == count) c->deep = 2 - c->deep;
    }
}
/* Is a place of a part's at `at` that does not touch within the range of a law? Most are, or they
   were not found; an ellipsoid's by its gap to the point of its own that comes there. */
static int demi_place_near(const dem_world *w, const demi_part *p, dem_vec3 at,
                           const demi_touching *place) {
    const dem_real scale = 1 - place->overlap;
    return p->kind != DEMI_ELLIPSOID || place->overlap > 0 ||
        demi_length(demi_sub(place->point, at))*(1 - 1/scale) < demi_range(w, p->radius);
}
/* Contacts of part k of a body with one wall: all of them, then what each continues. shaped: 0 for
   a sphere, which has a copy of the code: its places weigh by themselves, as they are found. */
DEM_INLINE void demi_kept_on_wall(dem_world *w, demi_view *v, int body, int shaped, int k,
                                  const demi_part *p, const demi_kept *old, int olds) {
    const demi_wall *wall = v->wall;
    const int d = v->d, id = (int)(wall - w->walls);
    const dem_vec3 at = v->at = demi_add(demi_at(w->bodies.pos + 4*body), p->centre);
    demi_touching *found = w->touching + w->domains[d].touching_first;
    const int places = demi_touches[wall->kind][p->kind](v, p, found);
    demi_kept *fresh = 0, *c;
    int i, e, count = 0;
    for (i = 0; i < places; i++) {
        if (shaped && w->margin.reach > 0 && !demi_place_near(w, p, at, &found[i])) continue;
        c = demi_kept_new(w, d);
        if (!c) return;
        if (!count++) fresh = c;
        c->a = body;
        c->part_a = k;
        c->wall = id;
        c->element = found[i].element;
        c->normal = found[i].normal;
        c->share = c->weight = c->lift = c->grip = found[i].share;
        c->shift = found[i].shift;
        if (!shaped || p->kind == DEMI_BALL) {  /* the commonest, without a call */
            demi_ball_on_wall(w, wall, p, &found[i], c);
            if (shaped && w->desc.cluster_contacts == DEM_CLUSTER_CONTACTS_MERGED && c->overlap > 0)
                demi_wall_bend(wall, v->element, v->left,
                               DEMI_MAX(p->radius - c->overlap, p->radius/10),
                               demi_add(found[i].point, c->shift), c);
        } else demi_on_walls[p->kind](w, wall, p, &found[i], c);
        c->r_eff = (dem_real)demi_wall_r_eff(wall, (double)c->r_eff);
    }
    for (i = 0, c = fresh; i < count; i++, c++)
        c->from = !shaped || !c->corners ? demi_kept_same(w, d, old, olds, c)
            : demi_kept_best(w, d, old, olds, fresh, count, c,
                             demi_response_is(w, DEMI_PRESSING) ? DEMI_FIT_TURNED
                                                                : DEMI_FIT_NEAREST);
    for (i = 0, c = fresh; i < count; i++, c++) {
        if (c->from < 0 && olds)
            c->from = demi_kept_best(w, d, old, olds, fresh, count, c, DEMI_FIT_SLID);
        if (c->deep > DEM_R(0.1) && olds) demi_kept_through(old, olds, fresh, count, c);
        if (wall->sieve.kind != DEM_SIEVE_REDUCED) continue;
        for (e = 0; e < olds; e++)              /* under way: to the end */
            if (old[e].b < 0 && old[e].wall == id && old[e].part_a == k && c->overlap > 0 &&
                !demi_kept_asked(w, &old[e])) c->weight = c->lift = c->grip = c->share = 0;
        if (!(c->share > 0)) c->overlap = c->deep = 0;
    }
}
/* Is a ball clear of what its body may touch of a wall? Told at once for a plane, which most balls
   of a cluster beside it are clear of; 0: to be looked at. */
DEM_INLINE int demi_ball_clear(const demi_view *v, dem_vec3 at, dem_real r) {
    const dem_real *R = v->wall->pose.rotation;
    dem_vec3 x;
    if (v->wall->kind != DEMI_WALL_PLANE || v->left > 1) return 0;
    x = demi_sub(demi_add(at, demi_at(v->from)), v->wall->pose.position);
    return R[2]*x.x + R[5]*x.y + R[8]*x.z > (r + demi_range(v->w, r))*DEM_R(1.001);
}
/* Of one body with one wall. */
static DEMI_APART void demi_kept_wall(dem_world *w, int d, int first, int last,
                                      const demi_kept *old, int olds) {
    const int from = w->domains[d].kept_next, body = w->wall_body[d*w->wall_stride + first];
    const int parts = demi_parts_count(w, body);
    demi_view v = demi_view_of(w, d, first, last);
    const dem_real *balls;
    dem_real lone[4];
    int k, count;
    if (!demi_shape_of(w, body)) {
        const demi_part sphere = demi_part_now(w, body, 0);
        demi_kept_on_wall(w, &v, body, 0, 0, &sphere, old, olds);
        return;
    }
    balls = demi_balls_of(w, body, lone, &count);
    for (k = 0; k < parts; k++) {
        demi_part p;
        if (balls && demi_ball_clear(&v, demi_add(demi_at(w->bodies.pos + 4*body),
                                                  demi_at(balls + 4*k)), balls[4*k + 3])) continue;
        p = demi_part_now(w, body, k);
        demi_kept_on_wall(w, &v, body, 1, k, &p, old, olds);
    }
    demi_kept_share(w, w->kept_next + w->kept_first[d] + from, w->domains[d].kept_next - from);
}
/* Do two contacts of one body with walls belong to one surface: of one part, with walls that do not
   move against each other? */
DEM_INLINE int demi_kept_beside(const dem_world *w, const demi_kept *a, const demi_kept *b) {
    return a->part_a == b->part_a && w->walls[a->wall].group == w->walls[b->wall].group;
}
/* How much of what contact e takes away comes off c's friction, by weight: nothing where they are
   not of one surface or do not push the same way; all, where they are at one place. */
static double demi_kept_nearness(const dem_world *w, const demi_kept *e, const demi_kept *c) {
    const dem_vec3 d = demi_add(demi_sub(c->arm_a, e->arm_a),
        demi_sub(demi_scale(e->normal, e->overlap), demi_scale(c->normal, c->overlap)));
    const double hair = 1e-9*(double)e->r_eff;
    dem_real rate;
    if (!(c->weight > 0) || !(c->overlap > 0) || !demi_kept_beside(w, e, c)) return 0;
    return (double)demi_kept_along(e, c, &rate)/((double)demi_dot(d, d) + hair*hair);
}
/* A place that takes away (where rows of a sieve cross, at the edge of a valley of facets) has no
   friction of its own, since what gives way there would give energy. That of those beside it counts
   so much less instead, springs and limits alike, the nearest most: one that it cancels has none,
   two that begin as one hold together what the one did, and mu is still the ratio of both sums. */
static void demi_kept_crossed(const dem_world *w, demi_kept *c, int n) {
    const int hertz = demi_normal_is(w, DEMI_HERTZIAN);
    int i, k;
    for (k = 0; k < n; k++) {
        double all = 0;
        if (!(c[k].weight < 0)) continue;
        c[k].grip = 0;
        for (i = 0; i < n && c[k].overlap > 0; i++) all += demi_kept_nearness(w, &c[k], &c[i]);
        for (i = 0; i < n && all > 0; i++) {
            const dem_real part = (dem_real)(demi_kept_nearness(w, &c[k], &c[i])/all);
            if (part > 0) c[i].held += part*c[k].weight*demi_kept_steep(&c[k], &c[i], hertz, 0);
        }
    }
    for (k = 0; k < n; k++) {                   /* held: what is taken away, until it is used */
        if (c[k].held < 0) c[k].grip *= DEMI_MAX(1 + c[k].held/c[k].weight, DEM_R(0));
        c[k].held = 0;
    }
}
/* A place of a surface that ends at depth, since another one has taken its part over, hands its
   springs to that: the one that pushes most nearly the same way. */
static void demi_kept_ended(const dem_world *w, int d, const demi_kept *old, int olds,
                            demi_kept *c, int n) {
    const int first = (int)(old - demi_kept_of(w, d));
    int e, i;
    for (e = 0; e < olds; e++) {
        const demi_wall *wall = old[e].b < 0 ? &w->walls[old[e].wall] : 0;
        dem_real nearest = DEM_R(0.95);
        demi_kept *heir = 0;
        if (!wall || !(old[e].grip > 0) ||
            !(demi_faceted(wall) || demi_wall_is(wall, DEMI_CROSSED))) continue;
        for (i = 0; i < n && c[i].from != first + e; i++) {
            const dem_real along = demi_dot(old[e].normal, c[i].normal);
            if (!(along > nearest) || c[i].from < 0 || c[i].share < 0 ||
                c[i].corner != old[e].corner ||
                !(2*old[e].overlap > c[i].overlap) || !demi_kept_beside(w, &old[e], &c[i]))
                continue;
            nearest = along;
            heir = &c[i];
        }
        if (i == n && heir && !heir->send) heir->send = 1 + first + e;
    }
}
/* All of one body with walls, when all are there: how often friction counts, and what of a step ago
   it begins with. */
static void demi_kept_settle(const dem_world *w, int d, const demi_kept *old, int olds,
                             demi_kept *c, int n) {
    const demi_kept *now = demi_kept_of(w, d);
    if (n == 1 && olds <= 1) { c->held = -1; return; }      /* do not fetch the old one yet */
    demi_kept_crossed(w, c, n);
    demi_kept_ended(w, d, old, olds, c, n);
    demi_kept_inherit(now, c, n);
}

/* All of one domain, in the order of body a: its pairs inside, its pairs that lead out, its walls.
   */
static void demi_domain_kept_touch(dem_world *w, int d) {
    demi_domain *domain = &w->domains[d];
    const demi_kept *old = demi_kept_of(w, d), *end = old + domain->kept, *old_end;
    const int32_t *near_a = w->near.a + d*w->near.stride;
    const int32_t *body = w->wall_body + d*w->wall_stride, *wall = w->wall_id + d*w->wall_stride;
    const dem_real *gap = w->wall_gap + d*w->wall_stride, gone = demi_walls_gone(w);
    const int base = d*w->near.stride, walls = domain->walls;
    const int own_end = domain->near_shaped_cross, cross_end = domain->near_shaped_end;
    const int send = 1 + d*w->cross.stride + domain->near_end - domain->near_cross - own_end;
    int p = domain->near_shaped, q = own_end, k = 0, a, last, walled;
    domain->kept_next = domain->kept_same = 0;
    domain->overflow &= ~16;
    for (; !(domain->overflow & 16); old = old_end) {
        while (k < walls && gap[k] > gone) k++; /* not near yet */
        a = k < walls ? body[k] : INT_MAX;
        if (p < own_end) a = DEMI_MIN(a, near_a[p]);
        if (q < cross_end) a = DEMI_MIN(a, near_a[q]);
        if (a == INT_MAX) return;
        while (old < end && old->a < a) old++;
        for (old_end = old; old_end < end && old_end->a == a;) old_end++;
        if (old_end + 1 < end) DEMI_FETCH(old_end + 1);     /* too far apart for hardware */
        if (k + DEMI_LANES < walls) DEMI_FETCH(w->bodies.pos + 4*body[k + DEMI_LANES]);
        for (; p < own_end && near_a[p] == a; p++)
            demi_kept_pair(w, d, base + p, 0, old, (int)(old_end - old));
        for (; q < cross_end && near_a[q] == a; q++)
            demi_kept_pair(w, d, base + q, send + q, old, (int)(old_end - old));
        walled = domain->kept_next;
        for (; k < walls && body[k] == a; k = last) {
            last = k + 1;
            if (gap[k] > gone) continue;
            while (last < walls && body[last] == a && wall[last] == wall[k]) last++;
            demi_kept_wall(w, d, k, last, old, (int)(old_end - old));
        }
        if (domain->kept_next > walled)
            demi_kept_settle(w, d, old, (int)(old_end - old),
                             w->kept_next + w->kept_first[d] + walled, domain->kept_next - walled);
    }
}
/* More room for the domains that ran out of it. 0 when memory ran out; nothing changed then. */
static int demi_kept_widen(dem_world *w) {
    int first[DEMI_DOMAINS + 1], d;
    for (d = 0, first[0] = 0; d < DEMI_DOMAINS; d++) {
        const int had = w->kept_first[d + 1] - w->kept_first[d];
        const int more = d < w->domain_count && w->domains[d].overflow & 16 ? had/2 + 64 : 0;
        first[d + 1] = first[d] + had + more;
    }
    if (!DEMI_GROW(w, w->kept_next, (size_t)first[DEMI_DOMAINS]) ||
        !DEMI_GROW(w, w->kept_now, (size_t)first[DEMI_DOMAINS])) return 0;
    for (d = w->domain_count - 1; d > 0; d--)
        memmove(w->kept_now + first[d], demi_kept_of(w, d),
                (size_t)w->domains[d].kept*sizeof(demi_kept));
    memcpy(w->kept_first, first, sizeof w->kept_first);
    return 1;
}
/* All of them. 0 when memory ran out. */
static int demi_touch(dem_world *w) {
    int d, again;
    for (d = 0; d < w->domain_count; d++) w->domains[d].kept_next = 0;
    if (!w->wall_count && !w->bodies.shaped) return 1;
    if ((!w->facets_valid && !demi_facets_weigh(w)) ||
        (!w->touching_valid && !demi_touching_reserve(w))) return 0;
    do {
        demi_parallel(w, w->desc.threads, w->domain_count, demi_domain_kept_touch);
        for (d = 0, again = 0; d < w->domain_count; d++) again |= w->domains[d].overflow & 16;
        if (again && !demi_kept_widen(w)) return 0;
    } while (again);
    return 1;
}
