/* ---------------------------------------------------------------------------------------------
   >>advice
   The critical time step: the step that a scene allows, from the durations of collisions and the
   stability limits of contacts that may occur, from the contacts that exist now, from spins and
   from speeds. It chooses the step if desc.dt is 0, and rejects a given step that is too long, with
   a message that names the cause. Owns dt, the reasons for it (clock.held), and work arrays (press,
   press_whole, pressed). Reads everything else. A head (h) considers all members of its team.
   --------------------------------------------------------------------------------------------- */

/* Returns the largest speed of a wall's surface during its motion, m/s. */
static double demi_motion_speed(const demi_wall *wall) {
    return demi_pose_speed(wall) + (double)demi_length(wall->glide);
}
/* Returns the unit vector of gravity, or 0 without gravity. */
static dem_vec3 demi_down(const dem_world *w) {
    return demi_length(w->desc.gravity) > 0 ? demi_unit(w->desc.gravity) : demi_v(0, 0, 0);
}
/* Radius of the sphere, m, that replaces a body when contact times are estimated. For a shape with
   a sphere of equal volume of radius `equal`, the mass of that sphere is the smallest effective
   mass that a contact may find. The Hertz contact time is proportional to (m^2/R)^(1/5). So if the
   radius of curvature of the flattest point is larger, the mass is also multiplied by the root of
   the ratio of the two radii. demi_advise_radius: the same for a body. */
static double demi_advise_shape(const dem_world *w, const demi_shape *shape, double equal) {
    const double scale = equal/(double)shape->equal, r = equal*demi_cube_root(shape->light);
    const double sharp = r/((double)shape->blunt*scale);
    return demi_normal_is(w, DEMI_HERTZIAN) && sharp < 1 ? r*demi_pow(sharp, 1.0/6) : r;
}
static double demi_advise_radius(const dem_world *w, int body) {
    const demi_shape *shape = demi_shape_of(w, body);
    const double r = (double)demi_radius(w, body);
    return shape ? demi_advise_shape(w, shape, (double)shape->equal*(r/(double)shape->radius)) : r;
}
/* Returns the largest step, s, at which velocity Verlet with predicted velocities integrates
   x'' = -omega2 x - rate x' stably: omega2 dt^2/4 + rate dt = 1. (For the other integrators it is
   about the same.) */
static double demi_dt_stable(double omega2, double rate) {
    return 2/(rate + sqrt(rate*rate + omega2) + 1e-300);
}
/* Returns the derivatives of a contact's force with respect to displacement and velocity at an
   overlap (m); the stability of a step depends on them. A user-defined law: desc.law_stiffness. */
static demi_stiffness demi_stiffness_of(const dem_world *w, const dem_real *coef, double m_eff,
                                        double overlap) {
    const double root = sqrt(overlap), r = (double)coef[DEMI_R_EFF];
    const double arm = (double)coef[DEMI_MU_ROLL]*r;
    demi_stiffness s = demi_stiffness_normal(w, coef, overlap);
    s.kt = (double)coef[DEMI_KT]; s.ct = (double)coef[DEMI_CT];
    if (demi_normal_is(w, DEMI_HERTZIAN)) { s.kt *= root; s.ct *= sqrt(root); }
    if (demi_rolling_laws[demi_rolling_meant(w)].traits & DEMI_SPRUNG) {
        s.kr = 2.25*s.k*arm*arm;
        s.cr = 0.6*sqrt(s.kr*1.4*m_eff*r*r);
    }
    if (demi_normal_is(w, DEMI_BRANCHED)) s.k = (double)coef[DEMI_K_UN];
    if (w->desc.tangent_law == DEM_TANGENT_NONE || !(coef[DEMI_MU_STATIC] > 0)) s.kt = s.ct = 0;
    if (w->desc.law) {
        memset(&s, 0, sizeof s);
        s.k = (double)w->desc.law_stiffness;
    }
    return s;
}
/* Returns the largest stable step, s, for a collision of two spheres at a speed (m/s): the limit at
   the largest overlap. */
static double demi_dt_of_contact(const dem_world *w, const dem_real *coef, double m_eff,
                                 double speed) {
    const double deep = demi_pow(5*m_eff*speed*speed/(4*(double)coef[DEMI_KN]), 0.4);
    const demi_stiffness s = demi_stiffness_of(w, coef, m_eff, deep);
    const double I = 0.4*m_eff*(double)coef[DEMI_R_EFF]*(double)coef[DEMI_R_EFF];
    const double slide = 3.5*s.kt/m_eff + s.kr/I;
    return demi_dt_stable(DEMI_MAX(s.k/m_eff, slide), DEMI_MAX(s.c/m_eff, 3.5*s.ct/m_eff + s.cr/I));
}
/* The properties of the grains of all members, and of those that feeds will insert, on which the
   choice of a time step depends. Radii are those of demi_advise_radius. */
typedef struct demi_grades {
    double smallest[DEMI_MATERIALS], peg[DEMI_MATERIALS];  /* m, by material: smallest radius of
                                      bodies that can move; largest of fixed bodies */
    double many[DEMI_MATERIALS];   /* by material: number of bodies that can move */
    double bodies;                 /* number of all bodies */
    double speed, spin;            /* largest speed, m/s; spin of bodies that are not spheres,
                                      rad/s */
    double lo, hi;                 /* m, extent of the bodies along gravity */
} demi_grades;
/* Adds the bodies of one member, without its ghosts. */
static void demi_grades_add(const dem_world *w, demi_grades *g) {
    const dem_vec3 down = demi_down(w);
    int i;
    for (i = 0; i < w->bodies.count; i++) {
        const int m = w->bodies.material[i] - 1;
        const double h = (double)demi_dot(demi_at(w->bodies.pos + 4*i), down);
        const double r = (double)demi_radius(w, i), equal = demi_advise_radius(w, i);
        if (demi_is_ghost(w, i)) continue;
        g->bodies++;
        g->speed = DEMI_MAX(g->speed, (double)demi_length(demi_at(w->bodies.vel + 4*i)));
        g->lo = DEMI_MIN(g->lo, h - r);
        g->hi = DEMI_MAX(g->hi, h + r);
        if (w->bodies.shaped && w->bodies.shape[i])
            g->spin = DEMI_MAX(g->spin, (double)demi_length(demi_at(w->bodies.spin + 4*i)));
        if (w->bodies.inv_mass[i] <= 0) { g->peg[m] = DEMI_MAX(g->peg[m], equal); continue; }
        if (!(g->many[m] > 0) || equal < g->smallest[m]) g->smallest[m] = equal;
        g->many[m]++;
    }
}
/* Fills in *g for all members and all processes. Feeds count as if two grains of each of their
   classes were there already. */
static dem_result demi_grades_of(const dem_world *h, demi_grades *g) {
    dem_result result = DEM_OK;
    int i, j;
    memset(g, 0, sizeof *g);
    g->lo = 1e300;
    g->hi = -1e300;
    for (i = 0; i < demi_members(h); i++) demi_grades_add(demi_member(h, i), g);
    if (h->team) result = h->team->grades((dem_world *)h, g);
    for (i = 0; i < h->feed_count; i++) {
        const dem_feed_desc *d = &demi_feed_at(h, i)->desc;
        for (j = 0; j < d->class_count; j++) {
            const int m = demi_feed_material(d, j);
            const double r = d->shapes[j].id
                ? demi_advise_shape(h, &h->shapes[d->shapes[j].id - 1], (double)d->radius[j])
                : (double)d->radius[j];
            if (!(g->many[m] > 0) || r < g->smallest[m]) g->smallest[m] = r;
            g->many[m] += 2;
        }
    }
    return result;
}
/* Returns the impact speed to expect, m/s: desc.impact_speed, or if that is 0 the largest speed of
   grains, feeds, walls and of a fall through the height of the scene; at least 1e-3. */
static double demi_speed_estimate(const dem_world *w, const demi_grades *g) {
    const dem_vec3 down = demi_down(w);
    const double gravity = (double)demi_length(w->desc.gravity);
    double speed = g->speed, lo = g->lo, hi = g->hi;
    int i, k;
    if (w->desc.impact_speed > 0) return (double)w->desc.impact_speed;
    for (i = 0; i < w->feed_count; i++) {       /* grains to be inserted */
        const dem_feed_desc *d = &demi_feed_at(w, i)->desc;
        for (k = 0; k < 2; k++) {
            const double h = (double)demi_dot(k ? d->box.hi : d->box.lo, down);
            lo = DEMI_MIN(lo, h);
            hi = DEMI_MAX(hi, h);
        }
        speed = DEMI_MAX(speed, (double)demi_length(d->velocity) + 1.7320508*(double)d->spread);
    }
    for (i = 0; i < w->wall_count; i++) {
        const demi_wall *wall = &w->walls[i];
        if (wall->kind == DEMI_WALL_NONE) continue;
        speed = DEMI_MAX(speed, demi_motion_speed(wall));
        if (demi_wall_is(wall, DEMI_FLAT) || (wall->vertex_count &&
                                              !demi_wall_is(wall, DEMI_DRAWN))) {
            const int n = DEMI_MAX(wall->vertex_count, 1);
            for (k = 0; k < n; k++) {
                const dem_vec3 p = !wall->vertex_count ? wall->pose.position :
                    demi_add(wall->pose.position, demi_rotate(wall->pose.rotation,
                                                            demi_at(wall->vertices + 3*k)));
                hi = DEMI_MAX(hi, (double)demi_dot(p, down));
            }
        } else hi = DEMI_MAX(hi, (double)demi_dot(wall->pose.position, down) +
                             (double)DEMI_MAX(wall->radius, wall->extent));
    }
    if (gravity > 0 && hi > lo) speed = DEMI_MAX(speed, sqrt(2*gravity*(hi - lo)));
    if (w->cell.on) speed = DEMI_MAX(speed, demi_cell_speed(w));
    return DEMI_MAX(speed, 1e-3);
}
/* The shortest contact among those examined so far, and the smallest stable step. */
typedef struct demi_shortest {
    /* s: contact time; stable step, possibly of another contact; m: radii, partner 0: a wall */
    double time, limit, radius, partner;
    int material, other, wall;     /* indices of materials, -1: no contact yet; wall: its id, 0:
                                      two grains */
} demi_shortest;
/* Examines the smallest grain of material i in contact with a wall (index, material `other`) or, if
   wall is -1, with the smallest grain of material `other`; if `fixed`, its largest fixed one. */
static void demi_advise_pair(const dem_world *w, const demi_grades *g, int i, int other, int fixed,
                             int wall, double speed, demi_shortest *s) {
    const double r = g->smallest[i], m = demi_sphere_mass(w, i, r);
    double m_eff = m, r_eff = r, partner = 0, t;
    dem_real coef[DEMI_COEFS];
    if (wall < 0) {
        partner = fixed ? g->peg[other] : g->smallest[other];
        if (!(partner > 0)) return;
        if (!fixed) m_eff = 1/(1/m + 1/demi_sphere_mass(w, other, partner));
        r_eff = r*partner/(r + partner);
    }
    demi_coefficients(w, i, other, r_eff, m_eff, m_eff, wall >= 0, coef);
    if (w->desc.law && w->desc.law_stiffness > 0)
        t = DEMI_PI*sqrt(m_eff/(double)w->desc.law_stiffness);
    else {
        t = demi_contact_time(w, coef, m_eff, speed);
        s->limit = DEMI_MIN(s->limit, demi_dt_of_contact(w, coef, m_eff, speed));
    }
    if (t >= s->time) return;
    s->time = t > 1e-37 ? t : 1e-37;            /* 0 would mean: no contact */
    s->radius = r;
    s->partner = partner;
    s->material = i;
    s->other = other;
    s->wall = wall < 0 ? 0 : w->walls[wall].id;
}
/* Returns the Rayleigh time of a grain, s: pi r sqrt(rho/G)/(0.1631 nu + 0.8766), the time in which
   a surface wave travels half round it; 1e300 if G is 0. */
static double demi_rayleigh(const dem_material_desc *d, double r) {
    const double nu = (double)d->poisson, G = (double)d->young/(2*(1 + nu));
    return G > 0 ? DEMI_PI*r*sqrt((double)d->density/G)/(0.1631*nu + 0.8766) : 1e300;
}
/* Names what limits dt_max: a fraction of the contact time, or stability if that is smaller. */
static const char *demi_dt_limit(const dem_advice *a) {
    return (double)a->dt_max < 0.0499*(double)a->contact_time
        ? "the stability limit of dashpots and rolling" : "t_c/20";
}
/* Computes the advice from the shortest contact among all pairs of materials, and with all walls,
   of their smallest grains. Pairs that ignore each other do not count. A lone grain is paired with
   one of its kind: for the contact time, but not for the stability limit. */
static void demi_advise_by(const dem_world *w, const demi_grades *g, dem_advice *out) {
    const double speed = demi_speed_estimate(w, g);
    double rayleigh = 1e300;
    demi_shortest s = {1e300, 1e300, 0, 0, -1, -1, 0};
    int i, j;
    for (i = 0; i < w->material_count; i++) {
        if (!(g->smallest[i] > 0)) continue;
        rayleigh = DEMI_MIN(rayleigh, demi_rayleigh(&w->materials[i], g->smallest[i]));
        for (j = 0; j < w->material_count; j++)
            if ((j != i || g->many[i] > 1) && !demi_ignores(w, i, j))
                demi_advise_pair(w, g, i, j, 0, -1, speed, &s);
        for (j = 0; j < w->material_count; j++)
            if (!demi_ignores(w, i, j)) demi_advise_pair(w, g, i, j, 1, -1, speed, &s);
        for (j = 0; j < w->wall_count; j++)
            if (w->walls[j].kind != DEMI_WALL_NONE && !demi_ignores(w, i, w->walls[j].material))
                demi_advise_pair(w, g, i, w->walls[j].material, 0, j, speed, &s);
    }
    for (i = 0; i < w->material_count && s.material < 0; i++)     /* a lone grain */
        if (g->smallest[i] > 0) {
            const double limit = s.limit;
            demi_advise_pair(w, g, i, i, 0, -1, speed, &s);
            s.limit = limit;
        }
    memset(out, 0, sizeof *out);
    out->speed = (dem_real)speed;
    out->rayleigh = (dem_real)(rayleigh < 1e300 ? rayleigh : 0);
    if (s.material < 0) {
        demi_words(out->binds, sizeof out->binds, "no grain that moves");
        s.time = 0;
    } else if (s.wall)
        demi_words(out->binds, sizeof out->binds, "grains of material %d, radius %g m, on wall %d "
                   "of material %d, at %.3g m/s", s.material + 1, s.radius, s.wall, s.other + 1,
                     speed);
    else
        demi_words(out->binds, sizeof out->binds, "grains of materials %d and %d, radii %g and %g "
                   "m, at %.3g m/s", s.material + 1, s.other + 1, s.radius, s.partner, speed);
    out->contact_time = (dem_real)s.time;
    out->dt = (dem_real)DEMI_MIN(s.time/50, s.limit/5);
    out->dt_max = (dem_real)DEMI_MIN(s.time/20, s.limit);
    if (s.time > 0 && s.limit < s.time/20) {
        const size_t n = strlen(out->binds);
        demi_words(out->binds + n, sizeof out->binds - n, "; stable to %.3g s because of its "
                   "dashpot, friction or rolling", s.limit);
    }
}
static void demi_advise(const dem_world *w, dem_advice *out) {
    demi_grades g;
    demi_grades_of(w, &g);
    demi_advise_by(w, &g, out);
}

/* --- stability with the contacts that exist now ("pressed" contacts: compressed, and several per
       grain). Small motions x about a state, with stiffness K, damping C and mass M, become
       unstable first in a mode that changes sign from step to step. Velocity Verlet with predicted
       velocities is stable while
           dt^2/4 K + dt C < M    (all eigenvalues of M^-1 times the left side are below 1)
       A contact stores k (n.(xa - xb))^2/2 <= k [(1 + Ra/Rb) (n.xa)^2 + (1 + Rb/Ra) (n.xb)^2]/2.
       So the condition holds for the whole scene if it holds for each body with its own contacts
       alone, each counted f = 1 + Ra/Rb times (once if the partner does not move). For one body the
       left side is a 6 x 6 matrix with the blocks
           A = sum f [k n n + kt (1 - n n)]/m  (displacement),
           B = sum f [kt l^2 + kr] (1 - n n)/I  (rotation),
           Q = sum f kt l [n x]/sqrt(m I)  (coupling of the two),
       n outwards, l the distance of the contact point from the centre; likewise for damping.
       Contacts with walls count with their weights, as their forces do (>>facets: the weights of
       one contact with a curved surface add up to one; some are negative). The bound is exact for
       close packings that shear and spin, and for one body between walls. A cheap bound is tested
       first: the sum, over a body's contacts, of the largest eigenvalue of each. Few bodies need
       the matrices. Spheres only. Test: "a step just inside the limit of pressed contacts is
       stable; one 5 % outside oscillates". --- */
/* The contacts of one body. */
typedef struct demi_press {
    double omega2, rate;           /* 1/s2, 1/s: the cheap bound, as in demi_dt_stable */
    double contacts;               /* their number, the sum of their weights */
    double relax;                  /* 1/s: rate at which its user-defined numbers approach those of
                                      its partners (desc.law_rate) */
    int32_t whole;                 /* 1 + index of its matrices, 0: none needed */
    dem_real deepest;              /* largest overlap, relative to its radius */
} demi_press;
/* The matrices of one body: blocks A, B and Q. A and B: upper triangle, row by row. q: the sum of
   f kt l n, of which Q is the cross product. First index 0: stiffness, 1/s2; 1: damping, 1/s. */
typedef struct demi_press_whole {
    double A[2][6], B[2][6], q[2][3];
} demi_press_whole;
/* One contact as a body has it. */
typedef struct demi_pressed {
    demi_stiffness s;
    dem_vec3 n;                    /* unit normal, outwards */
    dem_real overlap, weight;      /* m; 1 for two spheres */
} demi_pressed;
/* Adds a contact to a body's cheap bound: the stiffness of all contacts is added as if they were
   along one line. Contacts of negative weight are left out. f as above; arm: l, m. */
static void demi_press_add(const dem_world *w, int body, const demi_pressed *c, double f,
                           double arm, demi_press *p) {
    const double m = (double)w->bodies.mass[body];
    const double I = demi_sphere_inertia(w, m, (double)demi_radius(w, body));
    if (w->bodies.inv_mass[body] <= 0) return;
    p->contacts += (double)c->weight;
    if (!(c->weight > 0)) return;
    p->omega2 += f*DEMI_MAX(c->s.k/m, c->s.kt*(1/m + arm*arm/I) + c->s.kr/I);
    p->rate += f*DEMI_MAX(c->s.c/m, c->s.ct*(1/m + arm*arm/I) + c->s.cr/I);
    p->deepest = DEMI_MAX(p->deepest, c->overlap/demi_radius(w, body));
}
/* Adds a contact to a body's matrices, for the close bound. */
static void demi_press_add_whole(const dem_world *w, int body, const demi_pressed *c, double f,
                                 double arm, demi_press_whole *p) {
    const double m = (double)w->bodies.mass[body];
    const double I = demi_sphere_inertia(w, m, (double)demi_radius(w, body));
    const double n[3] = {(double)c->n.x, (double)c->n.y, (double)c->n.z};
    int i, j, e = 0, d;
    if (w->bodies.inv_mass[body] <= 0) return;
    for (i = 0; i < 3; i++)
        for (j = i; j < 3; j++, e++)
            for (d = 0; d < 2; d++) {
                const double nn = n[i]*n[j], across = (i == j ? 1 : 0) - nn;
                const double k = d ? c->s.c : c->s.k, kt = d ? c->s.ct : c->s.kt;
                p->A[d][e] += f*(k*nn + kt*across)/m;
                p->B[d][e] += f*(kt*arm*arm + (d ? c->s.cr : c->s.kr))*across/I;
            }
    for (d = 0; d < 2; d++)
        for (i = 0; i < 3; i++) p->q[d][i] += f*(d ? c->s.ct : c->s.kt)*arm*n[i]/sqrt(m*I);
}
/* True if a step is stable for one body: if 1 minus its matrix dt^2/4 K + dt C is positive
   definite, that is if it has a Cholesky factor L. */
static int demi_press_stable(const demi_press_whole *p, double dt) {
    static const int at[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
    const double by[2] = {dt*dt/4, dt};
    double L[6][6];
    int i, j, k, d;
    for (i = 0; i < 6; i++)
        for (j = 0; j <= i; j++) {
            double s = i == j ? 1 : 0;
            const int e = at[i%3][j%3];
            for (d = 0; d < 2; d++) {
                if (i/3 == j/3) s -= by[d]*(i < 3 ? p->A[d][e] : p->B[d][e]);
                else if (i%3 != j) s -= by[d]*p->q[d][3 - i%3 - j]*((i - j)%3 == 1 ? 1 : -1);
            }
            for (k = 0; k < j; k++) s -= L[i][k]*L[j][k];
            if (i == j && !(s > 0)) return 0;
            L[i][j] = i == j ? sqrt(s) : s/L[j][j];
        }
    return 1;
}
/* Returns the largest stable step of one body, s, at most dt, by bisection. */
static double demi_press_step(const demi_press_whole *p, double dt) {
    double lo = 0, hi = dt;
    int k;
    if (demi_press_stable(p, dt)) return dt;
    for (k = 0; k < 40; k++) {
        const double middle = (lo + hi)/2;
        if (demi_press_stable(p, middle)) lo = middle; else hi = middle;
    }
    return lo;
}
/* Calls desc.law_rate for one contact, and adds the rates at which it changes the user-defined
   numbers of body a and of body b (-1: a wall), times `weight`, to their `relax`. */
static void demi_press_relax(const dem_world *w, int a, int b, int wall, dem_contact *c,
                             double weight, demi_press *press) {
    dem_real rates[2] = {0, 0};
    c->user = w->desc.law_user;
    c->dt = w->clock.dt;
    c->material_a = w->bodies.material[a];
    c->material_b = b >= 0 ? w->bodies.material[b] : w->walls[wall].material + 1;
    c->wall = b >= 0 ? 0 : w->walls[wall].id;
    c->who.a = dem_body_id_get(w, a);
    if (b >= 0) c->who.b = dem_body_id_get(w, b);
    c->who.radius_a = demi_radius(w, a);
    c->who.radius_b = b >= 0 ? demi_radius(w, b) : 0;
    c->who.mass_a = w->bodies.mass[a];
    c->who.mass_b = b >= 0 ? w->bodies.mass[b] : 0;
    c->who.time = w->clock.time;
    c->who.reals_a = w->bodies.reals + w->bodies.real_count*a;
    c->who.reals_b = b >= 0 ? w->bodies.reals + w->bodies.real_count*b : w->walls[wall].reals;
    c->m_eff = b < 0 ? c->who.mass_a : 1/(1/c->who.mass_a + 1/c->who.mass_b);
    DEMI_USER(w, "an estimate of the time step", 1, w->desc.law_rate(c, rates))
    press[a].relax += weight*(double)rates[0];
    if (b >= 0) press[b].relax += weight*(double)rates[1];
}
/* Does so for all contacts that exist, of all shapes, if there is a desc.law_rate. */
static void demi_press_rates(const dem_world *w, demi_press *press) {
    dem_contact c;
    int d, p;
    for (d = 0; d < w->domain_count && w->desc.law_rate; d++) {
        const demi_domain *domain = &w->domains[d];
        for (p = demi_near_first(domain); p < domain->near_end; p = demi_near_next(domain, p)) {
            const demi_span span = demi_span_of(w, d, p, 1);
            const size_t at = (size_t)d*span.stride + (size_t)p;
            const dem_vec3 gap = demi_near_way(w, at);
            const dem_real ra = demi_near_radius(w, at, 0), rb = demi_near_radius(w, at, 1);
            const dem_real l = demi_length(gap), sum = ra + rb;
            memset(&c, 0, sizeof c);
            c.range = demi_range(w, sum);
            c.overlap = sum - l;
            c.normal = demi_scale(gap, 1/DEMI_MAX(l, DEMI_TINY));
            c.r_eff = ra*rb/sum;
            if (c.overlap > -c.range) demi_press_relax(w, span.a[0], span.b[0], -1, &c, 1, press);
        }
        for (p = 0; p < domain->persistent; p++) {
            const demi_persistent *k = demi_persistent_of(w, d) + p;
            memset(&c, 0, sizeof c);
            c.range = w->margin.reach > 0 ? demi_range(w, demi_persistent_radii(w, k)) : 0;
            c.overlap = k->overlap;
            c.normal = k->normal;
            c.r_eff = k->r_eff;
            if (c.overlap > -c.range)
                demi_press_relax(w, k->a, k->b, k->wall, &c, (double)k->share, press);
        }
    }
}
/* Returns the largest step at which a body's user-defined numbers are stable, s, at most dt. */
static double demi_press_rate_step(const demi_press *p, double dt) {
    return p->relax*dt > 1 ? 1/p->relax : dt;
}
/* Adds all contacts of spheres, with each other and with walls, to the cheap bounds of their
   bodies; or, if `whole` is not null, to the matrices of the bodies that have any. */
static void demi_press_visit(const dem_world *w, demi_press *press, demi_press_whole *whole) {
    int d, p, side;
    for (d = 0; d < w->domain_count; d++) {
        const demi_domain *domain = &w->domains[d];
        for (p = demi_near_first(domain); p < domain->near_end; p = demi_near_next(domain, p)) {
            const demi_span span = demi_span_of(w, d, p, 1);
            const int a = span.a[0], b = span.b[0];
            const dem_real *x = w->bodies.pos + 4*a, *y = w->bodies.pos + 4*b;
            const dem_vec3 gap = demi_add(demi_sub(demi_at(y), demi_at(x)),
                                          demi_at(w->image_shift + span.image[0]));
            const dem_real l = demi_length(gap), sum = x[3] + y[3];
            const int both = w->bodies.inv_mass[a] > 0 && w->bodies.inv_mass[b] > 0;
            dem_real coef[DEMI_TILE_COLUMNS];
            demi_pressed c;
            if (!(l < sum) || !(l > 0) || demi_shape_of(w, a) || demi_shape_of(w, b)) continue;
            if (whole && !press[a].whole && !press[b].whole) continue;
            demi_span_coefs(w, &span, 0, coef);
            c.s = demi_stiffness_of(w, coef, (double)coef[DEMI_M_EFF], (double)(sum - l));
            c.overlap = sum - l;
            c.weight = 1;
            for (side = 0; side < 2; side++) {
                const int i = side ? b : a;
                const double arm = (double)(l*(side ? y[3] : x[3])/sum);
                const double f = both ? (double)(sum/(side ? x[3] : y[3])) : 1;
                c.n = demi_scale(gap, (side ? -1 : 1)/l);
                if (!whole) demi_press_add(w, i, &c, f, arm, press + i);
                else if (press[i].whole)
                    demi_press_add_whole(w, i, &c, f, arm, whole + press[i].whole - 1);
            }
        }
        for (p = 0; p < domain->persistent; p++) {
            const demi_persistent *k = demi_persistent_of(w, d) + p;
            const int i = k->a;
            const double arm = (double)demi_radius(w, i);
            dem_real coef[DEMI_COEFS], root[2];
            demi_pressed c;
            if (!(k->overlap > 0) || k->b >= 0 || demi_shape_of(w, i) ||
                (whole && !press[i].whole)) continue;
            demi_persistent_coefs(w, k, coef, root);
            coef[DEMI_CN] += root[0]*DEMI_SQRT(w->bodies.mass[i]);
            coef[DEMI_CT] += root[1]*DEMI_SQRT(w->bodies.mass[i]);
            c.s = demi_stiffness_of(w, coef, (double)w->bodies.mass[i], (double)k->overlap);
            c.s.k *= (double)k->lift;
            c.s.c *= (double)k->share;
            c.s.kt *= (double)k->grip; c.s.ct *= (double)k->grip;
            c.s.kr *= (double)k->grip; c.s.cr *= (double)k->grip;
            c.n = k->normal;
            c.overlap = k->overlap;
            c.weight = k->share;
            if (!whole) demi_press_add(w, i, &c, 1, arm, press + i);
            else demi_press_add_whole(w, i, &c, 1, arm, whole + press[i].whole - 1);
        }
    }
}
/* Two records (demi_record) of ghosts, which are added to those of their owners: the cheap bound,
   and the matrices. */
static size_t demi_press_size(const dem_world *w) { return sizeof *w->press; }
static void demi_press_put(const dem_world *w, int i, char *to) {
    memcpy(to, w->press + i, sizeof *w->press);
}
static void demi_press_take(dem_world *w, int i, const char *from) {
    demi_press *sum = w->press + i, part;
    memcpy(&part, from, sizeof part);
    sum->omega2 += part.omega2;
    sum->rate += part.rate;
    sum->contacts += part.contacts;
    sum->relax += part.relax;
    sum->deepest = DEMI_MAX(sum->deepest, part.deepest);
}
static size_t demi_whole_size(const dem_world *w) { return sizeof *w->press_whole; }
static void demi_whole_put(const dem_world *w, int i, char *to) {
    memcpy(to, w->press_whole + i, sizeof *w->press_whole);
}
static void demi_whole_take(dem_world *w, int i, const char *from) {
    double *sum = (double *)(void *)(w->press_whole + i), part;
    size_t k;
    for (k = 0; k < sizeof *w->press_whole/sizeof part; k++) {
        memcpy(&part, from + k*sizeof part, sizeof part);
        sum[k] += part;
    }
}
/* Compute the cheap bounds of all bodies, and the matrices of those that need them. In a team all
   bodies get matrices, because a member does not know which of its ghosts need them. */
static dem_result demi_member_press(dem_world *w) {
    const size_t n = (size_t)w->bodies.count;
    if (!DEMI_GROW(w, w->press, n)) return demi_no_memory(w, "dem_world_step");
    if (n) memset(w->press, 0, n*sizeof *w->press);
    demi_press_visit(w, w->press, 0);
    demi_press_rates(w, w->press);
    return DEM_OK;
}
static dem_result demi_member_press_whole(dem_world *w) {
    int i, found = 0;
    for (i = 0; i < w->bodies.count; i++)
        if (w->team || w->pressed.dt > demi_dt_stable(w->press[i].omega2, w->press[i].rate))
            w->press[i].whole = ++found;
    if (!DEMI_GROW(w, w->press_whole, (size_t)found)) return demi_no_memory(w, "dem_world_step");
    if (found) memset(w->press_whole, 0, (size_t)found*sizeof *w->press_whole);
    if (found) demi_press_visit(w, w->press, w->press_whole);
    return DEM_OK;
}
/* Returns the largest stable step of body i, s, at most w->pressed.dt: by the cheap bound or, if
   `whole`, by its matrices (a body without matrices does not limit the step by its forces). */
static double demi_press_body(const dem_world *w, int i, int whole) {
    const demi_press *p = w->press + i;
    const double rates = demi_press_rate_step(p, w->pressed.dt);
    if (!whole) return DEMI_MIN(rates, demi_dt_stable(p->omega2, p->rate));
    return p->whole ? demi_press_step(w->press_whole + p->whole - 1, rates) : rates;
}
/* Finds the smallest of these steps over all bodies of all members, and stores it in `pressed` of
   the head and of each member, with the member's own smallest one and the body that limits it. */
static dem_result demi_press_least(dem_world *h, int whole) {
    double least = -h->pressed.dt;              /* negative, because members agree on maxima */
    dem_result result;
    int i, k;
    for (k = 0; k < demi_members(h); k++) {
        dem_world *w = demi_member(h, k);
        w->pressed.limit = w->pressed.dt;
        for (i = 0; i < w->bodies.count; i++) {
            const double limit = demi_is_ghost(w, i) ? w->pressed.dt : demi_press_body(w, i, whole);
            if (limit < w->pressed.limit) { w->pressed.limit = limit; w->pressed.worst = i; }
        }
        least = DEMI_MAX(least, -w->pressed.limit);
    }
    result = demi_agree(h, &least, 1);
    for (k = 0; k < demi_members(h); k++) demi_member(h, k)->pressed.least = -least;
    h->pressed.least = -least;
    return result;
}
/* Sets h->pressed.least to the largest stable step with the contacts that exist now, s, at most dt.
   The matrices are computed only if the cheap bound is below dt. */
static dem_result demi_press_limit(dem_world *h, double dt) {
    static const demi_record bound = {demi_press_size, demi_press_put, demi_press_take};
    static const demi_record whole = {demi_whole_size, demi_whole_put, demi_whole_take};
    dem_result result;
    int k;
    h->pressed.dt = dt;
    for (k = 0; k < demi_members(h); k++) demi_member(h, k)->pressed.dt = dt;
    result = demi_all_agree(h, demi_member_press);
    if (result == DEM_OK && h->team) result = h->team->give(h, &bound);
    if (result == DEM_OK) result = demi_press_least(h, 0);
    if (result != DEM_OK || !(h->pressed.least < dt)) return result;
    result = demi_all_agree(h, demi_member_press_whole);
    if (result == DEM_OK && h->team) result = h->team->give(h, &whole);
    return result == DEM_OK ? demi_press_least(h, 1) : result;
}

/* Fails because a body that is not a sphere rotates too far in a step. rate: its spin, rad/s. */
static dem_result demi_spins_refuse(dem_world *w, double rate, const char *call) {
    return demi_fail(w, DEM_ERROR_TIME_STEP, "%s: step %llu: a body that is not a sphere rotates "
                     "by %.3g rad in a step of %g s, must be at most 1; its spin is %.3g rad/s: "
                     "use dt = 0 or at most %.2g s, or find what spun it up", call,
                     (unsigned long long)w->clock.steps, rate*(double)w->clock.dt,
                     (double)w->clock.dt, rate, 0.1/rate);
}
DEM_API dem_result dem_step_advice_get(const dem_world *w, dem_advice *advice) {
    if (demi_null_look(w, __func__, advice, "advice")) return DEM_ERROR_ARGUMENT;
    if (!demi_response_is(w, DEMI_LASTING)) {
        const double rests = demi_rest_limit(w)/1.5;
        char most[96] = "";
        if (rests > 0)
            demi_words(most, sizeof most, ", and at most %.2g s, so that polyhedra rest on each "
                       "other", rests);
        return demi_refuse(w, __func__, "contacts of this world are impulses, which "
                           "have no contact time; choose a step in which grains move by less than "
                           "a tenth of their radius%s", most);
    }
    demi_advise(w, advice);
    if (advice->contact_time > 0) return DEM_OK;
    return demi_refuse(w, __func__, "the world has no grain that can move; add grains "
                       "before this call");
}
/* Fails because the chosen step is so short that the time would not advance. */
static dem_result demi_dt_refuse(dem_world *w, double dt, const char *by) {
    return demi_fail(w, DEM_ERROR_TIME_STEP, "dem_world_step: the contacts of the scene need a "
                     "step of %g s, must be at least %g s, or time does not advance (shortest: "
                     "%s); a stiffness, damping, rolling friction or speed is far too large, or a "
                     "grain far too light: find it with dem_world_check_print", dt, DEMI_DT_LEAST,
                     by);
}
/* Springs: settles the time step for the present scene. Chooses it, with the reasons for the
   report, or checks the given one, and fails if that is too long. First completes the open half
   kick, so that a change of dt does not affect it. */
static dem_result demi_springs_settle(dem_world *h) {
    dem_advice a;
    demi_grades g;
    dem_result result = demi_all(h, demi_member_finish);  /* velocities at the present time */
    if (result == DEM_OK) result = demi_grades_of(h, &g);
    if (result != DEM_OK) return result;
    if (!(g.bodies > 0) && !h->feed_count) {    /* nothing to limit it: walls still move */
        if (h->desc.dt > 0 || !(h->clock.dt > 0))
            h->clock.dt = h->desc.dt > 0 ? h->desc.dt : DEM_R(1e-3);
        demi_dt_share(h);
        return DEM_OK;
    }
    demi_advise_by(h, &g, &a);
    if (h->desc.dt > 0) {
        if (!h->desc.allow_large_dt && a.contact_time > 0 && !(h->desc.dt <= a.dt_max))
            return demi_fail(h, DEM_ERROR_TIME_STEP, "dem_world_step: dt is %g s, must be at most "
                             "%s = %g s (t_c of %s); use dt = 0, a softer material or a smaller dt",
                             (double)h->desc.dt, demi_dt_limit(&a), (double)a.dt_max, a.binds);
        h->clock.dt = h->desc.dt;
        if (!h->desc.allow_large_dt && g.spin*(double)h->clock.dt > 1)
            return demi_spins_refuse(h, g.spin, "dem_world_step");
    } else {
        const dem_real easy = a.contact_time > 0 ? a.dt : DEM_R(1e-3);
        const dem_real share = h->dt_share > 0 ? (dem_real)h->dt_share : 1;
        const dem_real dt = share*(g.spin*(double)easy > 0.1 ? (dem_real)(0.1/g.spin) : easy);
        if (!((double)dt >= DEMI_DT_LEAST)) return demi_dt_refuse(h, (double)dt, a.binds);
        if (dt < h->clock.dt || dt > h->clock.dt) demi_halves_outdated(h);
        h->clock.dt = dt;
        h->clock.held.from = (double)a.contact_time/50;
        h->clock.held.limit = dt < share*easy ? g.spin : 5*(double)a.dt;
        h->clock.held.by = dt < share*easy ? DEMI_HELD_SPIN
            : (double)easy < 0.99*h->clock.held.from ? DEMI_HELD_DASHPOT : DEMI_HELD_NOT;
    }
    h->clock.assumed_speed = (double)a.speed;
    h->clock.press_due = h->clock.steps;
    demi_dt_settled(h);
    demi_dt_share(h);
    return DEM_OK;
}
/* True if grains are so much faster than the assumed impact speed that the step must be chosen
   again. A given impact speed stays in force. */
static int demi_outgrown(const dem_world *w) {
    return demi_response_is(w, DEMI_LASTING) && !(w->desc.impact_speed > 0) &&
        w->booked.speed_max > 1.5*w->clock.assumed_speed;
}
/* Returns the largest speed, m/s, that a body may have in the next step by the present forces: a
   bound, with the midpoint rule the exact speed. */
static double demi_fastest_next(const dem_world *w) {
    double most = 0;
    int i, k;
    for (i = 0; i < w->bodies.count; i++) {
        const double inv = (double)w->bodies.inv_mass[i];
        const double g[3] = {(double)w->desc.gravity.x, (double)w->desc.gravity.y,
                             (double)w->desc.gravity.z};
        double a2 = 0, v2 = 0;
        if (demi_is_ghost(w, i)) continue;      /* its force here is incomplete */
        for (k = 0; k < 3; k++) {
            const double a = (double)w->bodies.force[4*i + k]*inv + g[k];
            const double v = (double)w->bodies.vel[4*i + k] + a*(double)w->clock.dt;
            a2 += a*a;
            v2 += v*v;
        }
        if (inv > 0 && demi_response_is(w, DEMI_MIDWAY)) most = DEMI_MAX(most, sqrt(v2));
        else if (inv > 0)
            most = DEMI_MAX(most, (double)demi_length(demi_at(w->bodies.vel + 4*i)) +
                            sqrt(a2)*(double)w->clock.dt);
    }
    return most;
}
/* Fails if the fastest body may move farther than the smallest radius in a step, because it could
   pass through others and walls undetected. Where contacts are found ahead of time (impulses), it
   may move as far as half the distance at which they are found, since both bodies move. speed: an
   upper bound, m/s. */
static dem_result demi_speed_check(dem_world *w, double speed) {
    const int foreseen = demi_response_is(w, DEMI_FORESEEN);
    const double seen = foreseen ? demi_foreseen(w)/2 : 0;
    const double radius = (double)w->effects.radius_min, dt = (double)w->clock.dt;
    double most = 0;
    char who[80] = "a body";
    int i, k;
    if (!(speed*dt > DEMI_MAX(radius, seen) && radius > 0)) return DEM_OK;
    for (k = 0; k < demi_members(w); k++) {
        const demi_bodies *bodies = &demi_member(w, k)->bodies;
        for (i = 0; i < bodies->count; i++) {
            const double v = (double)demi_length(demi_at(bodies->vel + 4*i));
            if (v <= most) continue;
            most = v;
            demi_words(who, sizeof who, "body %u, the fastest, is at %.3g m/s and",
                       (unsigned)bodies->slot[i] + 1, v);
        }
    }
    return demi_fail(w, DEM_ERROR_TIME_STEP, "dem_world_step: step %llu: %s may reach %.3g m/s in "
                     "this step: it moves %.3g radii of the smallest grain (%g m) in a step of %g "
                     "s, must be at most 1: it would pass through others and walls undetected; use "
                     "at most %.2g s%s, or find what made it so fast",
                     (unsigned long long)w->clock.steps, who, speed, speed*dt/radius, radius, dt,
                     0.1*radius/speed, foreseen ? ", or a law_range of twice that distance" : "");
}
/* The same for moving walls that are thin. Planes and cylinders are not: a body on their other side
   still touches them. */
static dem_result demi_wall_speed_check(dem_world *w, double radius, double dt) {
    int i;
    for (i = 0; i < w->wall_count; i++) {
        const demi_wall *wall = &w->walls[i];
        const int kind = wall->kind;
        double speed;
        if (kind == DEMI_WALL_NONE || kind == DEMI_WALL_PLANE || kind == DEMI_WALL_CYLINDER ||
            wall->motion.kind == DEM_MOTION_FIXED || !(radius > 0)) continue;
        speed = wall->motion.kind == DEM_MOTION_SERVO ? demi_pose_speed(wall)
                                                      : demi_wall_speed(wall);
        if (!(speed*dt > radius)) continue;
        return demi_fail(w, DEM_ERROR_TIME_STEP, "dem_world_step: step %llu: wall %d moves at up "
                         "to %.3g m/s, %.3g radii of the smallest grain (%g m) in a step of %g s, "
                         "must be at most 1: it would pass through grains undetected; use at most "
                         "%.2g s, or a slower wall", (unsigned long long)w->clock.steps,
                         (int)wall->id, speed, speed*dt/radius, radius, dt, 0.1*radius/speed);
    }
    return DEM_OK;
}
/* Schedules the next examination of the present contacts: at increasing intervals while the scene
   does not change, at least every 1000 steps. With desc.law_rate at least every eight steps,
   because user-defined numbers become unstable sooner. */
static void demi_press_looked(dem_world *h) {
    const uint64_t since = h->clock.steps - h->clock.press_since;
    h->clock.press_due = h->clock.steps + DEMI_MIN(8*since + 8, h->desc.law_rate ? 8 : 1000);
}
/* Fails because the given step is not stable, in the member that has the body with the smallest
   limit; the others return DEM_OK. */
static dem_result demi_member_press_refuse(dem_world *w) {
    const demi_press *p = w->press + w->pressed.worst;
    const double limit = w->pressed.limit;
    if (limit > w->pressed.least || !(limit < w->pressed.dt)) return DEM_OK;
    if (p->relax*limit > 0.999)
        return demi_fail(w, DEM_ERROR_TIME_STEP, "dem_world_step: step %llu: dt is %g s, must be "
                         "at most %g s: by desc.law_rate the numbers of body %u follow those of "
                         "its partners at %.3g 1/s; use dt = 0, a smaller dt, or slower rates",
                         (unsigned long long)w->clock.steps, (double)w->clock.dt, limit,
                         (unsigned)w->bodies.slot[w->pressed.worst] + 1, p->relax);
    return demi_fail(w, DEM_ERROR_TIME_STEP, "dem_world_step: step %llu: dt is %g s, must be at "
                     "most %g s: body %u is pressed by %.3g contacts with overlaps up to %.3g of "
                     "its radius; use dt = 0, a smaller dt, or less overlap",
                     (unsigned long long)w->clock.steps, (double)w->clock.dt, limit,
                     (unsigned)w->bodies.slot[w->pressed.worst] + 1, p->contacts,
                     (double)p->deepest);
}
/* Sets *bound to an upper bound of the speed of all bodies in the next step, m/s: the last speed
   and the last change of velocity. After a change of the scene, and with the midpoint rule, it
   follows from the present forces: the last change may be that of a body that was removed since. */
static dem_result demi_speed_bound(dem_world *h, double *bound) {
    const int midway = demi_response_is(h, DEMI_MIDWAY);
    int k;
    *bound = h->margin.last_change + h->booked.speed_max;
    if (!midway && h->clock.steps != h->clock.press_since) return DEM_OK;
    *bound = 0;
    for (k = 0; k < demi_members(h); k++) {
        const dem_world *w = demi_member(h, k);
        const double next = demi_fastest_next(w);
        *bound = DEMI_MAX(*bound, midway ? next
                          : DEMI_MIN(demi_fastest(w) + h->margin.last_change, next));
    }
    return demi_agree(h, bound, 1);
}
/* Checks the step before bodies move, when lists and contacts are valid: against the speeds, and
   against the contacts that exist now. A chosen step is shortened to half of the stable one (see
   dt_share); a given step that is too long fails. */
static dem_result demi_dt_check(dem_world *h) {
    const int chosen = !(h->desc.dt > 0);
    const double share = h->dt_share > 0 ? h->dt_share : 1, room = DEMI_MIN(share/2, 0.95);
    const double dt = (double)h->clock.dt*(chosen ? 2/share : 1);
    double bound, limit;
    dem_result result;
    if (h->desc.allow_large_dt || (!h->team && !h->bodies.count)) return DEM_OK;
    result = demi_speed_bound(h, &bound);
    if (result == DEM_OK) result = demi_speed_check(h, bound);
    if (result == DEM_OK)
        result = demi_wall_speed_check(h, (double)h->effects.radius_min, (double)h->clock.dt);
    if (result != DEM_OK || h->clock.steps < h->clock.press_due ||
        !demi_response_is(h, DEMI_LASTING)) return result;
    result = demi_press_limit(h, dt);
    if (result != DEM_OK) return result;
    demi_press_looked(h);
    limit = h->pressed.least;
    if (!(limit < dt)) return DEM_OK;
    if (!chosen) return demi_all_agree(h, demi_member_press_refuse);
    if (!(limit*room >= DEMI_DT_LEAST))
        return demi_dt_refuse(h, limit*room, "contacts that press a body");
    result = demi_all(h, demi_member_finish);
    demi_halves_outdated(h);
    h->clock.dt = (dem_real)(limit*room);
    h->clock.held.by = DEMI_HELD_PRESSED;
    h->clock.held.limit = limit;
    h->clock.held.body = 0;
    if (!h->team) {                             /* other processes would not know the body */
        const demi_press *p = h->press + h->pressed.worst;
        h->clock.held.by = p->relax*limit > 0.999 ? DEMI_HELD_RATE : DEMI_HELD_PRESSED;
        h->clock.held.body = (int32_t)h->bodies.slot[h->pressed.worst] + 1;
        h->clock.held.contacts = p->contacts;
    }
    demi_dt_share(h);
    return result;
}
