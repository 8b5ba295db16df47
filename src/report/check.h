/* ---------------------------------------------------------------------------------------------
   >>check
   Validation of a scene before it runs (dem_world_check). Each function looks for likely mistakes
   of one kind and adds a finding, a message with a severity, for each. This part reads the scene
   and changes none of it. Where contacts are needed, it rebuilds the neighbour list and detects
   contacts with walls, as a run would do first. The limits let practical scenes pass: grains from
   0.1 um to 0.5 m, densities from foam to osmium, moduli softened down to 1e4 Pa.
   --------------------------------------------------------------------------------------------- */

/* The caller's array of findings, sorted by descending severity. Findings of the same severity keep
   the order in which they were found. room: length of the array; kept: findings in it; count: all
   findings, those without room included. */
typedef struct demi_findings { dem_finding *to; int room, kept, count; } demi_findings;
/* Adds a finding. If the array is full, the least severe one is dropped. */
static void demi_find(demi_findings *f, dem_severity severity, const char *format, ...)
    DEMI_FORMAT(3, 4);
static void demi_find(demi_findings *f, dem_severity severity, const char *format, ...) {
    int i = f->kept;
    va_list arguments;
    f->count++;
    while (i > 0 && f->to[i - 1].severity < severity) i--;
    if (i >= f->room) return;
    if (f->kept < f->room) f->kept++;
    memmove(f->to + i + 1, f->to + i, (size_t)(f->kept - 1 - i)*sizeof *f->to);
    f->to[i].severity = severity;
    va_start(arguments, format);
    demi_words_of(f->to[i].text, sizeof f->to[i].text, format, arguments);
    va_end(arguments);
}

/* Writes the sets of materials of grains (also of those that feeds will insert) and of walls. Bit i
   is the material of index i. */
static void demi_made_of(const dem_world *w, uint64_t *grains, uint64_t *walls) {
    int i, k;
    *grains = *walls = 0;
    for (i = 0; i < w->bodies.count; i++) *grains |= UINT64_C(1) << (w->bodies.material[i] - 1);
    for (i = 0; i < w->feed_count; i++) {
        const dem_feed_desc *d = &demi_feed_at(w, i)->desc;
        for (k = 0; k < d->class_count; k++) *grains |= UINT64_C(1) << demi_feed_material(d, k);
    }
    for (i = 0; i < w->wall_count; i++)
        if (w->walls[i].kind != DEMI_WALL_NONE) *walls |= UINT64_C(1) << w->walls[i].material;
}
#define DEMI_COEF_COPY(PROPERTY, COEFFICIENT, UNIT) c.COEFFICIENT = k.COEFFICIENT;
/* Returns the name of a friction of material i (from 0) that desc.law ignores, or null. In a trial
   contact of two such grains, which begins and is 1 % of R* deep, the law exerts no moment against
   it. A law that sees the bodies (law_who) is not called: its user may have no data for them. */
static const char *demi_law_lacks(const dem_world *w, int i) {
    const dem_pair *p = &w->pairs[i*DEMI_MATERIALS + i].given;
    const dem_material m = {i + 1};
    dem_real memory[DEMI_MEMORY];
    dem_coefficients k;
    dem_contact c;
    dem_contact_force f;
    int twist;
    if (!w->desc.law || w->desc.law_who) return 0;
    for (twist = 0; twist < 2; twist++) {
        if (!((twist ? p->spinning_friction : p->rolling_friction) > 0)) continue;
        if (dem_coefficients_get(w, m, m, DEM_R(1e-3), DEM_R(1e-3), &k) != DEM_OK) continue;
        memset(&c, 0, sizeof c);
        memset(memory, 0, sizeof memory);
        demi_contact_usual(&c);
        c.r_eff = k.r_eff; c.m_eff = k.m_eff;
        c.kn = k.kn; c.cn = k.cn; c.kt = k.kt; c.ct = k.ct; c.kun = k.kun;
        DEM_LAW_COEFFICIENTS(DEMI_COEF_COPY)
        c.friction = c.friction_static = p->friction;
        c.rolling_friction = p->rolling_friction; c.spinning_friction = p->spinning_friction;
        c.overlap = k.r_eff/100;
        c.normal.z = 1;
        c.spin = c.spin_step = demi_v(twist ? 0 : DEM_R(1), 0, twist ? DEM_R(1) : 0);
        c.dt = w->clock.dt > 0 ? w->clock.dt : DEM_R(1e-6);
        c.material_a = c.material_b = i + 1;
        c.user = w->desc.law_user;
        demi_law(w, &c, memory, &f);
        if (!(demi_dot(f.moment, c.spin) < 0))
            return twist ? "spinning friction" : "rolling friction";
    }
    return 0;
}
/* Checks materials (values that suggest other units, materials without use) and the number of
   threads. */
static void demi_check_materials(const dem_world *w, demi_findings *f) {
    uint64_t grains, walls;
    int i;
    demi_made_of(w, &grains, &walls);
    for (i = 0; i < w->material_count; i++) {
        const dem_material_desc *m = &w->materials[i];
        const char *lacks = demi_law_lacks(w, i);
        if (!((grains | walls) >> i & 1))
            demi_find(f, DEM_SEVERITY_NOTE, "material %d is used by no grain, wall or feed", i + 1);
        if (m->density < 10 || m->density > 25000)
            demi_find(f, DEM_SEVERITY_WARNING, "material %d has a density of %g kg/m3: densities "
                      "are in kg/m3 (water has 1000), was %g g/cm3 meant?", i + 1,
                      (double)m->density, (double)(m->density < 10 ? m->density : m->density/1000));
        if (demi_response_is(w, DEMI_LASTING) && !w->desc.law && !(m->stiffness > 0) &&
            (m->young < DEM_R(1e4) || m->young > DEM_R(2e12)))
            demi_find(f, DEM_SEVERITY_WARNING, "material %d has a Young's modulus of %g Pa: "
                      "moduli are in Pa (glass has 7e10, softened grains 1e6 to 1e8)", i + 1,
                      (double)m->young);
        if (m->friction > 2)
            demi_find(f, DEM_SEVERITY_WARNING, "material %d has a friction of %g: it is a "
                      "coefficient, not an angle; tan(%g degrees) is %.3g", i + 1,
                      (double)m->friction, (double)m->friction,
                      demi_sin((double)m->friction*DEMI_PI/180)/
                      demi_cos((double)m->friction*DEMI_PI/180));
        if (m->rolling_friction > 1)
            demi_find(f, DEM_SEVERITY_WARNING,
                      "material %d has a rolling friction of %g: it is a fraction of the "
                      "effective radius, usually 0.01 to 0.3", i + 1, (double)m->rolling_friction);
        if (lacks)
            demi_find(f, DEM_SEVERITY_WARNING, "desc.law exerts no moment against the %s of "
                      "material %d, so its grains %s freely: define the law by DEM_LAW_ROLLING, "
                      "or set this friction to 0", lacks, i + 1, *lacks == 'r' ? "roll" : "spin");
        if (m->rolling_friction > 0 && !(m->friction > 0))
            demi_find(f, DEM_SEVERITY_NOTE, "material %d has rolling friction but no sliding "
                      "friction: its grains slide instead of rolling", i + 1);
    }
    if (w->desc.threads > demi_threads_available() && demi_threads_available() > 0)
        demi_find(f, DEM_SEVERITY_NOTE, "threads is %d, but only %d can run at once: more threads "
                  "make the run slower", w->desc.threads, demi_threads_available());
}
/* Computes the smallest and the largest (bounding) radius of all bodies, m; 1e300 and 0 if there
   are none. */
static void demi_radii_of(const dem_world *w, double *least, double *most) {
    int i;
    *least = 1e300;
    *most = 0;
    for (i = 0; i < w->bodies.count; i++) {
        *least = DEMI_MIN(*least, (double)demi_radius(w, i));
        *most = DEMI_MAX(*most, (double)demi_radius(w, i));
    }
}
static void demi_check_radii(const dem_world *w, demi_findings *f) {
    double least, most;
    demi_radii_of(w, &least, &most);
    if (most > 0.5)
        demi_find(f, DEM_SEVERITY_WARNING, "the largest grain has a radius of %g m: lengths are in "
                  "metres, was %g mm meant?", most, most);
    if (least < 1e-7)
        demi_find(f, DEM_SEVERITY_WARNING, "the smallest grain has a radius of %g m: below 1e-7 m "
                  "attraction and thermal motion outweigh the forces simulated here", least);
}
/* Checks the resolution of positions. A floating-point position far from the origin has too few
   digits left for overlaps, which are thousandths of a radius. In single precision the rebound of a
   bead from a plane is wrong by 1 % if adjacent positions are 2e-4 radii apart, and by 5 % at 2e-3;
   at 2e-2 the bead sticks to the plane. */
static void demi_check_digits(const dem_world *w, demi_findings *f) {
    const double digit = DEMI_SINGLE ? 1.1920929e-7 : 2.220446e-16;
    double worst = 0;
    int i, k, body = 0;
    for (i = 0; i < w->bodies.count; i++)
        for (k = 0; k < 3; k++) {
            const double part =
                fabs((double)w->bodies.pos[4*i + k])/(double)demi_radius(w, i)*digit;
            if (!(part > worst)) continue;
            worst = part;
            body = i;
        }
    if (worst > 2e-4)
        demi_find(f, worst > 2e-3 ? DEM_SEVERITY_WARNING : DEM_SEVERITY_NOTE, "body %d is so far "
                  "from the origin that its position is resolved only to %.2g of its radius: "
                  "contacts lose %s; build the scene around the origin%s",
                  (int)w->bodies.slot[body] + 1, worst, worst > 2e-3 ? "their accuracy"
                  : "about 1 % of accuracy", DEMI_SINGLE ? ", or use double precision" : "");
}

/* Returns the largest coordinate (m) along the unit vector n up to which a wall can stop a body
   that moves along n. 1e300: it is infinite in that direction. -1e300: it stops nothing (a plane
   parallel to n or seen from behind, a tube or profile seen along its axis). */
static double demi_wall_far(const demi_wall *wall, dem_vec3 n) {
    const dem_vec3 own = demi_unrotate(wall->pose.rotation, n);
    const int drawn = demi_wall_is(wall, DEMI_DRAWN);
    double far = -1e300;
    int i;
    if (demi_wall_is(wall, DEMI_FLAT)) return own.z < DEM_R(-1e-3) ? 1e300 : -1e300;
    if (DEMI_ABS(own.z) > DEM_R(0.999) && (drawn || (wall->extent < 0 && wall->radius > 0)))
        return -1e300;
    if (wall->extent < 0 || (drawn && DEMI_ABS(own.z) > DEM_R(1e-6))) return 1e300;
    for (i = 0; i < wall->vertex_count; i++)
        far = DEMI_MAX(far, (double)demi_dot(demi_at(wall->vertices + 3*i), own));
    if (!wall->vertex_count) far = (double)DEMI_MAX(wall->extent, wall->radius);
    else if (demi_wall_is(wall, DEMI_BALLS)) far += (double)wall->radius;
    return far + (double)demi_dot(wall->pose.position, n);
}
/* Returns the size of a wall, m: the longest side of its box, or its diameter if it has no
   vertices. */
static double demi_wall_size(const demi_wall *wall) {
    const dem_vec3 box = demi_sub(wall->box.hi, wall->box.lo);
    if (!wall->vertex_count) return 2*(double)wall->extent;
    return (double)DEMI_MAX(box.x, DEMI_MAX(box.y, demi_wall_is(wall, DEMI_DRAWN) ? 0 : box.z));
}
/* Checks that something can move, that something makes it move, and that gravity does not let it
   fall for ever. */
static void demi_check_motion(const dem_world *w, demi_findings *f) {
    const dem_vec3 g = demi_v(w->desc.gravity.x, w->desc.gravity.y,
                              w->desc.planar ? 0 : w->desc.gravity.z);
    const int pulled = demi_dot(g, g) > 0, forced = w->desc.force || w->desc.body_force;
    dem_vec3 down = pulled ? demi_unit(g) : demi_v(0, 0, 0);
    double lowest = -1e300, floor = -1e300, speed = 0;
    int i, moving = 0, driven = w->cell.on || w->desc.growth || w->feed_count;
    for (i = 0; i < w->bodies.count; i++) {
        const double h = (double)demi_dot(demi_at(w->bodies.pos + 4*i), down);
        if (w->bodies.inv_mass[i] <= 0) { floor = DEMI_MAX(floor, h); continue; }
        moving++;
        lowest = DEMI_MAX(lowest, h);
        speed = DEMI_MAX(speed, (double)demi_length(demi_at(w->bodies.vel + 4*i)));
    }
    if (!moving && !w->feed_count) {
        demi_find(f, DEM_SEVERITY_ERROR, "no grain can move, and there is no feed: add grains, "
                  "for example with dem_spheres_fill");
        return;
    }
    for (i = 0; i < w->wall_count; i++)
        driven |= w->walls[i].kind != DEMI_WALL_NONE &&
            (w->walls[i].motion.kind != DEM_MOTION_FIXED || w->walls[i].glides);
    if (!pulled && !forced && !driven && !(speed > 0) && moving)
        demi_find(f, DEM_SEVERITY_WARNING, "all grains rest, and there is neither gravity%s nor a "
                  "force field: set gravity (0, %s m/s2) or velocities",
                  w->desc.planar ? " in the plane" : "", w->desc.planar ? "-9.81, 0" : "0, -9.81");
    for (i = 0; i < w->wall_count; i++)
        if (w->walls[i].kind != DEMI_WALL_NONE)
            floor = DEMI_MAX(floor, demi_wall_far(&w->walls[i], down));
    if (pulled && moving && !forced && floor < lowest && !demi_joints_in_force(w) &&
        !demi_rails_in_force(w) && !demi_outflows(w) && !(DEMI_ABS(down.x) > DEM_R(0.1) &&
        w->desc.boundary[0] == DEM_BOUNDARY_PERIODIC) && !(DEMI_ABS(down.y) > DEM_R(0.1) &&
        w->desc.boundary[1] == DEM_BOUNDARY_PERIODIC) && !(DEMI_ABS(down.z) > DEM_R(0.1) &&
        w->desc.boundary[2] == DEM_BOUNDARY_PERIODIC))
        demi_find(f, DEM_SEVERITY_WARNING, "gravity is (%g, %g, %g) m/s2, but no wall or fixed "
                  "grain is below the lowest grain: grains fall for ever; add a floor, or change "
                  "the direction of gravity", (double)g.x, (double)g.y, (double)g.z);
}

/* Compares the velocity and spin that a user-defined motion gives at a time with the differences of
   its poses over d s. Returns 1 and fills the two vectors if they differ by more than 1 % and
   round-off. Of an infinite plane only the velocity along its normal counts. */
static int demi_motion_differs(const dem_world *w, const demi_wall *wall, double time,
                               double d, dem_vec3 *given, dem_vec3 *found) {
    const dem_real digit = DEMI_SINGLE ? DEM_R(1e-6) : DEM_R(2e-15), per = (dem_real)(1/d);
    dem_pose p[3];
    dem_vec3 v[2][2];
    dem_real W[9];
    int i, j, k;
    for (k = 0; k < 3; k++) {
        demi_wall_pose_at(w, wall, time + k*d/2, &p[k]);
        if (!demi_pose_sane(&p[k])) return 0;
    }
    for (i = 0; i < 3; i++)                     /* dR/dt R^T */
        for (j = 0; j < 3; j++)
            for (W[3*i + j] = 0, k = 0; k < 3; k++)
                W[3*i + j] += (p[2].rotation[3*i + k] - p[0].rotation[3*i + k])*per*
                    p[1].rotation[3*j + k];
    v[0][0] = p[1].velocity;
    v[0][1] = demi_scale(demi_sub(p[2].position, p[0].position), per);
    v[1][0] = p[1].spin;
    v[1][1] = demi_scale(demi_v(W[7] - W[5], W[2] - W[6], W[3] - W[1]), DEM_R(0.5));
    for (k = 0; k < 2; k++) {
        const dem_vec3 n = demi_rotate(p[1].rotation, demi_v(0, 0, 1)), off = demi_sub(v[k][0],
                                                                                       v[k][1]);
        const int flat = demi_wall_is(wall, DEMI_FLAT) && !k;
        const dem_real size = DEMI_MAX(demi_length(v[k][0]), demi_length(v[k][1]));
        *given = v[k][0];
        *found = v[k][1];
        if ((flat ? DEMI_ABS(demi_dot(off, n)) : demi_length(off)) > DEM_R(0.01)*size +
            digit*per*(k ? 1 : demi_length(p[1].position))) return 1 + k;
    }
    return 0;
}
/* Checks user-defined motions now and at later times, up to a million steps from now. */
static void demi_check_motions(dem_world *w, const dem_advice *a, demi_findings *f) {
    const double d = w->clock.dt > 0 ? (double)w->clock.dt : w->desc.dt > 0 ? (double)w->desc.dt
        : a->dt_max > 0 ? (double)a->dt_max/2 : 1e-6;
    int i, k, differs;
    for (i = 0; i < w->wall_count; i++) {
        const demi_wall *wall = &w->walls[i];
        double after = 0;
        dem_vec3 v = {0, 0, 0}, u = {0, 0, 0};
        if (wall->kind == DEMI_WALL_NONE || wall->motion.kind != DEM_MOTION_USER) continue;
        for (k = differs = 0; k < 8 && !differs; k++, after = after > 0 ? 10*after : d)
            differs = demi_motion_differs(w, wall, w->clock.time + after, d, &v, &u);
        if (!differs) continue;
        demi_find(f, DEM_SEVERITY_WARNING, "the motion of wall %d gives a %s of (%g, %g, %g) where "
                  "its %s changes by (%g, %g, %g) per second: contacts would create energy; give "
                  "the derivative or, for a belt, use dem_wall_surface_velocity_set", (int)wall->id,
                  differs == 1 ? "velocity" : "spin", (double)v.x, (double)v.y, (double)v.z,
                  differs == 1 ? "position" : "rotation", (double)u.x, (double)u.y, (double)u.z);
    }
}

/* True if the whole of a finite wall is behind some plane or beyond an outflow face of the domain,
   so that no grain can reach it. */
static int demi_wall_hidden(const dem_world *w, const demi_wall *wall) {
    double lo[3], hi[3];
    int k;
    if (demi_wall_is(wall, DEMI_DRAWN)) return 0;       /* infinite along its own z */
    demi_domain_limits(w, lo, hi);
    for (k = 0; k < w->wall_count; k++) {
        const demi_wall *plane = &w->walls[k];
        const dem_vec3 n = demi_rotate(plane->pose.rotation, demi_v(0, 0, 1));
        if (plane->kind == DEMI_WALL_NONE || !demi_wall_is(plane, DEMI_FLAT)) continue;
        if (demi_wall_far(wall, n) < (double)demi_dot(plane->pose.position, n)) return 1;
    }
    for (k = 0; k < 3; k++) {
        const dem_vec3 n = demi_v(k == 0, k == 1, k == 2);
        if (w->desc.boundary[k] == DEM_BOUNDARY_OUTFLOW &&
            (demi_wall_far(wall, n) < lo[k] || -demi_wall_far(wall, demi_scale(n, -1)) > hi[k]))
            return 1;
    }
    return 0;
}
/* Checks walls: size compared with that of grains, and whether grains can reach them. */
static void demi_check_walls(const dem_world *w, demi_findings *f) {
    double least, most;
    int i;
    demi_radii_of(w, &least, &most);
    for (i = 0; i < w->wall_count; i++) {
        const demi_wall *wall = &w->walls[i];
        const double size = demi_wall_size(wall);
        if (wall->kind == DEMI_WALL_NONE || wall->extent < 0) continue;
        if (most > 0 && size > 2e4*most)
            demi_find(f, DEM_SEVERITY_WARNING, "wall %d, a %s, is %g m long, %.3g radii of the "
                      "largest grain: was it in millimetres? scale it by 0.001", (int)wall->id,
                      demi_wall_kinds[wall->kind].name, size, size/most);
        else if (most > 0 && size < least)
            demi_find(f, DEM_SEVERITY_WARNING, "wall %d, a %s, is %g m long, less than the radius "
                      "of the smallest grain, %g m: is it in other units?", (int)wall->id,
                      demi_wall_kinds[wall->kind].name, size, least);
        if (demi_wall_hidden(w, wall))
            demi_find(f, DEM_SEVERITY_WARNING, "wall %d, a %s, is behind a plane or outside the "
                      "domain: nothing can reach it; does the plane's normal point to the grains?",
                      (int)wall->id, demi_wall_kinds[wall->kind].name);
    }
}

/* Checks for pairs of bodies that overlap by more than 1 % of the smaller radius; pairs of fixed
   bodies are exempt. Needs a valid neighbour list. */
static void demi_check_pairs(const dem_world *w, demi_findings *f) {
    double worst = 0.01;
    int d, k, cross, count = 0, who[2] = {0, 0};
    for (d = 0; d < w->domain_count; d++)
        for (cross = 0; cross < 2; cross++) {
            const demi_list *list = cross ? &w->cross : &w->own;
            const int from = d*list->stride, n = cross ? w->domains[d].cross : w->domains[d].own;
            for (k = from; k < from + n; k++) {
                const int a = list->a[k], b = list->b[k];
                const dem_real r = DEMI_MIN(demi_radius(w, a), demi_radius(w, b));
                const double deep = -(double)(demi_bodies_gap(w, a, b, w->image_shift +
                                                              list->image[k], r)/r);
                if (!(deep > 0.01) || demi_parted(w, a, b, -1) ||
                    (w->bodies.inv_mass[a] <= 0 && w->bodies.inv_mass[b] <= 0)) continue;
                count++;
                if (deep <= worst) continue;
                worst = deep;
                who[0] = (int)w->bodies.slot[a] + 1;
                who[1] = (int)w->bodies.slot[b] + 1;
            }
        }
    if (count)
        demi_find(f, worst >= 1 ? DEM_SEVERITY_ERROR : worst > 0.05 ? DEM_SEVERITY_WARNING
                  : DEM_SEVERITY_NOTE, "%d pair%s of grains begin%s with an overlap, bodies %d and "
                  "%d by %.3g of the smaller radius: they will fly apart; place them with "
                  "dem_spheres_fill, or farther apart", count, count > 1 ? "s" : "",
                  count > 1 ? "" : "s", who[0], who[1], worst);
}
/* Checks for bodies that overlap walls by more than 1 % of their radius. Detects contacts
   (demi_touch), and discards them afterwards. Needs a valid neighbour list. */
static void demi_check_in_walls(dem_world *w, demi_findings *f) {
    double worst = 0.01;
    int d, k, count = 0, body = 0, wall = 0;
    if (!demi_touch(w)) return;                 /* no memory: the run will report it */
    for (d = 0; d < w->domain_count; d++)
        for (k = 0; k < w->domains[d].persistent_next; k++) {
            const demi_persistent *c = w->persistent_next + w->persistent_first[d] + k;
            if (c->b >= 0 || !((double)c->deep > 0.01)) continue;
            count++;
            if ((double)c->deep <= worst) continue;
            worst = (double)c->deep;
            body = (int)w->bodies.slot[c->a] + 1;
            wall = w->walls[c->wall].id;
        }
    for (d = 0; d < w->domain_count; d++) w->domains[d].persistent_next = w->domains[d].persistent;
    if (count)
        demi_find(f, worst >= 1 ? DEM_SEVERITY_ERROR : worst > 0.05 ? DEM_SEVERITY_WARNING
                  : DEM_SEVERITY_NOTE, "grains overlap walls at %d place%s, body %d wall %d by "
                  "%.3g of its radius: move it, or does the normal (inside) of the wall point the "
                  "wrong way?", count, count > 1 ? "s" : "", body, wall, worst);
}
/* Checks for bodies whose centre is beyond an outflow face of the domain. */
static void demi_check_outside(const dem_world *w, demi_findings *f) {
    double lo[3], hi[3];
    int i, k, count = 0;
    demi_domain_limits(w, lo, hi);
    for (i = 0; i < w->bodies.count; i++)
        for (k = 0; k < 3; k++) {
            const double x = (double)w->bodies.pos[4*i + k];
            if (w->desc.boundary[k] != DEM_BOUNDARY_OUTFLOW || (x >= lo[k] && x <= hi[k])) continue;
            count++;
            break;
        }
    if (count)
        demi_find(f, DEM_SEVERITY_WARNING, "%d grain%s outside the domain, whose outflow faces "
                  "will remove them in the first step; make the domain larger", count,
                  count > 1 ? "s are" : " is");
}

/* --- Grains on both sides of a closed surface. Meshes, profiles and surfaces of revolution are
       thin shells that repel grains on both sides. Grains inside a body that was meant to be solid
       therefore touch nothing and stay there unnoticed. A closed container has all grains inside;
       if some grains are inside and others are not, one of the two is most likely a mistake. A
       shell is closed if an even number of its facets shares each edge (of profiles: each end
       point); the facets may belong to several walls that do not move against each other. A point
       is inside if a ray from it crosses the shell an odd number of times. --- */
/* A point that is tested: the centre of a grain, a point of a feed's region, or a periodic image of
   either. */
typedef struct demi_probe {
    double x[3];                   /* m, as seen from the surface before its motion began */
    int odd, turn;                 /* ray: 1 after an odd number of crossings; sum of their signs */
    int feed;                      /* 0: a grain; otherwise the number of the feed */
    int owner;                     /* number of the grain or point, the same for its images */
} demi_probe;
typedef struct demi_probes {
    demi_probe *at;                /* those in the box of the surface, sorted by y */
    int count, grains, places;     /* of `at`; grains that can move; points of feeds */
    int owners;                    /* grains + places */
    char *seen;                    /* of each owner: one of its images has been counted */
} demi_probes;
enum { DEMI_FEED_PLACES = 64 };    /* random points that represent the region of a feed */

static int demi_probe_compare(const void *a, const void *b) {
    const double x = ((const demi_probe *)a)->x[1], y = ((const demi_probe *)b)->x[1];
    return x < y ? -1 : x > y;
}
/* Adds the point x (m) and its periodic images, those of them in the box of the surface. box: m,
   lowest and highest corner of the surface at `home`, the pose at the start of its motion; points
   are transformed from the present pose to that one. A wall that repeats periodically may be any
   number of periods away from x: the images tested are those around the middle of the wall. Returns
   0 if memory runs out. */
static int demi_probe_add(dem_world *w, demi_probes *p, const demi_wall *wall, const double *box,
                          dem_vec3 x, int feed) {
    dem_real mid[3], to_mid[3];
    int n, k;
    for (k = 0; k < 3; k++) mid[k] = (dem_real)((box[k] + box[3 + k])/2);
    demi_put(mid, demi_add(wall->pose.position, demi_rotate(wall->pose.rotation, demi_unrotate(
        wall->home.rotation, demi_sub(demi_at(mid), wall->home.position)))));
    demi_put(to_mid, demi_sub(demi_at(mid), x));
    for (k = 0; k < 3; k++)
        to_mid[k] = wall->repeats[k]
            ? (dem_real)floor((double)(to_mid[k]/w->wall_period[k]) + 0.5)*w->wall_period[k] : 0;
    x = demi_add(x, demi_at(to_mid));
    for (n = 0; n < 27; n++) {
        const int s[3] = {n%3 - 1, n/3%3 - 1, n/9 - 1};
        const dem_vec3 by = demi_wall_shift(w, s[0], s[1], s[2]);
        const dem_vec3 own = demi_unrotate(wall->pose.rotation,
                                           demi_sub(demi_add(x, by), wall->pose.position));
        const dem_vec3 at = demi_add(wall->home.position, demi_rotate(wall->home.rotation, own));
        demi_probe *to;
        double c[3];
        int near = 1;
        c[0] = (double)at.x; c[1] = (double)at.y; c[2] = (double)at.z;
        for (k = 0; k < 3; k++)
            near = near && (!s[k] || w->wall_period[k] > 0) && c[k] >= box[k] && c[k] <= box[3 + k];
        if (!near) continue;
        if (!demi_grow(w, DEMI_LOOSE, &p->at, sizeof *p->at, (size_t)p->count + 1)) return 0;
        to = p->at + p->count++;
        memcpy(to->x, c, sizeof c);
        to->odd = to->turn = 0;
        to->feed = feed;
        to->owner = p->owners;
    }
    p->owners++;
    return 1;
}
static void demi_probes_free(dem_world *w, demi_probes *p) {
    demi_free(w, p->at);
    demi_free(w, p->seen);
}
/* Collects the grains that can move and do not ignore the wall, and the points of active feeds that
   are in the box of a surface, sorted by y. Returns 0 if memory runs out. */
static int demi_probes_make(dem_world *w, demi_probes *p, const demi_wall *wall,
                            const double *box) {
    int i, n, ok = 1;
    memset(p, 0, sizeof *p);
    for (i = 0; i < w->bodies.count && ok; i++) {
        if (!(w->bodies.inv_mass[i] > 0) ||
            demi_ignores(w, w->bodies.material[i] - 1, wall->material)) continue;
        p->grains++;
        ok = demi_probe_add(w, p, wall, box, demi_at(w->bodies.pos + 4*i), 0);
    }
    for (i = 0; i < w->feed_count && ok; i++) {
        const demi_feed *feed = demi_feed_at(w, i);
        uint64_t random = 1;
        demi_region g;
        if (feed->state.done || !demi_feed_region(w, &feed->desc, &g)) continue;
        for (n = 0; n < DEMI_FEED_PLACES && ok; n++) {
            const double u = demi_uniform(&random), v = demi_uniform(&random);
            const double at[3] = {u, v, demi_uniform(&random)};
            dem_vec3 x;
            if (!demi_region_at(&g, at, (dem_real)feed->lo[0], &x)) continue;
            p->places++;
            ok = demi_probe_add(w, p, wall, box, x, i + 1);
        }
    }
    if (!ok || !p->count) return ok;
    qsort(p->at, (size_t)p->count, sizeof *p->at, demi_probe_compare);
    p->seen = (char *)demi_alloc(w, (size_t)p->owners, 1);
    return p->seen != 0;
}
/* Adds a finding if some probes are inside the shell and others are not. wall: index; normals: 1 if
   its facets have an orientation, which the message then names. */
static void demi_probes_judge(const dem_world *w, demi_findings *f, const demi_probes *p, int wall,
                              int normals) {
    const char *name = demi_wall_kinds[w->walls[wall].kind].name, *way = "";
    int i, grains = 0, places = 0, feed = 0, turn = 0;
    if (p->count) memset(p->seen, 0, (size_t)p->owners);
    for (i = 0; i < p->count; i++) {
        if (!p->at[i].odd || p->seen[p->at[i].owner]++) continue;
        turn += p->at[i].turn > 0 ? 1 : -1;
        if (p->at[i].feed) { places++; feed = p->at[i].feed; } else grains++;
    }
    if (normals && turn) way = turn > 0 ? " with normals outwards" : " with normals inwards";
    if (!(grains + places) || grains + places == p->grains + p->places) return;
    if (grains)
        demi_find(f, *way && turn < 0 ? DEM_SEVERITY_NOTE : DEM_SEVERITY_WARNING, "%d of %d "
                  "grains begin inside wall %d, a closed %s%s, and stay inside: if the wall is "
                  "solid, keep them out (`inside` of dem_region) or remove them; if it is hollow, "
                  "all is well", grains, p->grains, (int)w->walls[wall].id, name, way);
    else
        demi_find(f, *way && turn < 0 ? DEM_SEVERITY_NOTE : DEM_SEVERITY_WARNING, "feed %d "
                  "inserts grains inside wall %d, a closed %s%s, and they stay inside: if the "
                  "wall is solid, keep them out (`inside` of the feed); if it is hollow, all is "
                  "well", feed, (int)w->walls[wall].id, name, way);
}
/* Tests, in the first two coordinates, whether the ray from x along the first axis crosses the
   segment from a to b. Returns 1 if it does and b is above the ray, -1 if it does and b is below,
   and 0 if it does not. The segment from b to a is computed identically, with the opposite sign, so
   no ray slips between two facets that share the segment. */
static int demi_probe_crosses(const double *a, const double *b, const double *x) {
    const int up = b[1] > x[1];
    const double *lo = up ? a : b, *hi = up ? b : a;
    if ((a[1] > x[1]) == up) return 0;
    if (!((lo[0] - x[0])*(hi[1] - x[1]) - (hi[0] - x[0])*(lo[1] - x[1]) > 0)) return 0;
    return up ? 1 : -1;
}
/* Counts the crossings of one facet by the rays from all probes: along x for a segment of a
   profile, along z for a triangle. A binary search finds the probes in reach: they are sorted by
   y. */
static void demi_probes_cross(const demi_join *j, int facet, demi_probes *p) {
    const int per = j->per;
    const double *c[3], *a, *b;
    double lo, hi, u[3], v[3], n[3];
    int k, from = 0, to = p->count;
    for (k = 0; k < 3; k++) c[k] = j->x + 3*j->facet[5*facet + (k < per ? k : 0)];
    lo = DEMI_MIN(c[0][1], DEMI_MIN(c[1][1], c[2][1]));
    hi = DEMI_MAX(c[0][1], DEMI_MAX(c[1][1], c[2][1]));
    for (k = 0; k < 3; k++) { u[k] = c[1][k] - c[0][k]; v[k] = c[2][k] - c[0][k]; }
    for (k = 0; k < 3; k++) n[k] = u[(k + 1)%3]*v[(k + 2)%3] - u[(k + 2)%3]*v[(k + 1)%3];
    while (from < to) {
        const int mid = from + (to - from)/2;
        if (p->at[mid].x[1] < lo) from = mid + 1;
        else to = mid;
    }
    for (; from < p->count && p->at[from].x[1] <= hi; from++) {
        demi_probe *at = p->at + from;
        int turn = 0;
        for (k = 0; k < (per == 3 ? 3 : 1); k++) {
            a = c[k];
            b = c[(k + 1)%3];
            turn += demi_probe_crosses(a, b, at->x);
        }
        if (!turn || (per == 3 && !((c[0][2] - at->x[2])*fabs(n[2]) >
            (n[0]*(at->x[0] - c[0][0]) + n[1]*(at->x[1] - c[0][1]))*(n[2] > 0 ? 1 : -1)))) continue;
        at->odd = !at->odd;
        at->turn += turn;
    }
}
/* Finds the shells (connected surfaces) of a join, by union-find over shared sides. root[i]
   receives the first facet of the shell that contains facet i, or -1 if that shell is open. */
static void demi_join_shells(demi_join *j, int32_t *root) {
    const demi_side *s = j->side;
    int i, end, sides;
    demi_join_sides(j);
    sides = j->sides;
    for (i = 0; i < j->facets; i++) root[i] = i;
    for (i = 1; i < sides; i++) {
        int32_t a = s[i - 1].facet, b = s[i].facet;
        if (s[i].lo != s[i - 1].lo || s[i].hi != s[i - 1].hi) continue;
        while (root[a] != a) a = root[a] = root[root[a]];
        while (root[b] != b) b = root[b] = root[root[b]];
        root[DEMI_MAX(a, b)] = DEMI_MIN(a, b);
    }
    for (i = 0; i < j->facets; i++) root[i] = root[root[i]];
    for (i = 0; i < sides; i = end) {
        const int32_t of = s[i].facet;
        end = demi_sides_end(s, sides, i);
        if ((end - i)%2) root[root[of] >= 0 ? root[of] : of] = -1;
    }
    for (i = 0; i < j->facets; i++) if (root[i] >= 0) root[i] = root[root[i]];
}
/* Checks all closed shells of the surface whose first wall this is. per: corners of a facet, 3 for
   meshes, 2 for profiles. Does nothing if memory runs out. */
static void demi_check_shells(dem_world *w, demi_findings *f, int wall, int per) {
    double box[6] = {1e300, 1e300, 1e300, -1e300, -1e300, -1e300};
    int32_t *root = 0, *next = 0;
    demi_probes p;
    demi_join j;
    int i, k, ok = demi_join_begin(w, &j, wall, per);
    memset(&p, 0, sizeof p);
    for (i = 0; i < 3*j.points && ok; i++) {
        box[i%3] = DEMI_MIN(box[i%3], j.x[i]);
        box[3 + i%3] = DEMI_MAX(box[3 + i%3], j.x[i]);
    }
    if (per == 2) { box[2] = -1e300; box[5] = 1e300; }
    if (ok) ok = demi_probes_make(w, &p, &w->walls[wall], box);
    if (ok && p.count) {
        ok = demi_join_resolve(w, &j);
        root = (int32_t *)demi_alloc(w, 2*(size_t)j.facets + 1, sizeof *root);
    }
    if (ok && root) {
        next = root + j.facets;
        demi_join_shells(&j, root);
        for (i = 0; i < j.facets; i++) next[i] = -1;
        for (i = j.facets - 1; i >= 0; i--) {   /* link the facets of a shell, its root first */
            if (root[i] < 0 || root[i] == i) continue;
            next[i] = next[root[i]];
            next[root[i]] = i;
        }
        for (i = 0; i < j.facets; i++) {
            if (root[i] != i) continue;
            for (k = 0; k < p.count; k++) p.at[k].odd = p.at[k].turn = 0;
            for (k = i; k >= 0; k = next[k]) demi_probes_cross(&j, k, &p);
            demi_probes_judge(w, f, &p, j.facet[5*i + 3], per == 3);
        }
    }
    demi_free(w, root);
    demi_probes_free(w, &p);
    demi_join_free(w, &j);
}
/* Checks a surface of revolution. */
static void demi_check_revolved(dem_world *w, demi_findings *f, int wall) {
    const demi_wall *s = &w->walls[wall];
    const int n = s->ring_count;
    const dem_real *r = s->ring_radius, *h = s->ring_height;
    const double e = (double)s->extent;
    const dem_vec3 x = s->home.position;
    double box[6];
    demi_probes p;
    int i, k;
    if (s->open) return;
    box[0] = (double)x.x - e; box[1] = (double)x.y - e; box[2] = (double)x.z - e;
    for (k = 0; k < 3; k++) box[3 + k] = box[k] + 2*e;
    if (demi_probes_make(w, &p, s, box)) {
        for (i = 0; i < p.count; i++) {
            const dem_vec3 at = demi_v((dem_real)p.at[i].x[0], (dem_real)p.at[i].x[1],
                                       (dem_real)p.at[i].x[2]);
            const dem_vec3 own = demi_unrotate(s->home.rotation, demi_sub(at, x));
            const double c[2] = {sqrt((double)(own.x*own.x + own.y*own.y)), (double)own.z};
            for (k = 0; k + 1 < n; k++) {
                const double a[2] = {(double)r[k], (double)h[k]};
                const double b[2] = {(double)r[k + 1], (double)h[k + 1]};
                if (demi_probe_crosses(a, b, c)) p.at[i].odd = !p.at[i].odd;
            }
        }
        demi_probes_judge(w, f, &p, wall, 0);
    }
    demi_probes_free(w, &p);
}
/* Checks all closed surfaces: each surface of revolution, and each surface of meshes or profiles
   once, for its first wall. */
static void demi_check_enclosed(dem_world *w, demi_findings *f) {
    int i, k;
    if (!w->facets_valid && !demi_surfaces_make(w)) return;  /* no memory: the run will report it */
    for (i = 0; i < w->wall_count; i++) {
        const demi_wall *wall = &w->walls[i];
        const int per = demi_wall_per(wall);
        if (wall->kind == DEMI_WALL_REVOLVED) demi_check_revolved(w, f, i);
        if (!demi_faceted(wall)) continue;
        for (k = 0; k < i && !(demi_faceted(&w->walls[k]) && demi_join_member(w, i, k, per));) k++;
        if (k == i) demi_check_shells(w, f, i, per);
    }
}

/* Compares desc.dt with the largest and the recommended time step of the scene, and with the
   distance that the fastest grain or wall moves in a step. */
static void demi_check_step(dem_world *w, const dem_advice *a, demi_findings *f) {
    const int lasting = demi_response_is(w, DEMI_LASTING);
    const double dt = (double)w->desc.dt, rests = lasting ? 0 : demi_rest_limit(w);
    double fastest = demi_fastest(w);
    int i;
    if (!(dt > 0) || (lasting && !(a->contact_time > 0))) return;
    for (i = 0; i < w->wall_count; i++)
        if (w->walls[i].kind != DEMI_WALL_NONE)
            fastest = DEMI_MAX(fastest, demi_motion_speed(&w->walls[i]));
    if (lasting && dt > (double)a->dt_max)
        demi_find(f, w->desc.allow_large_dt ? DEM_SEVERITY_WARNING : DEM_SEVERITY_ERROR, "dt is "
                  "%g s, must be at most %g s for %s: use dt = 0, or a softer material", dt,
                  (double)a->dt_max, a->binds);
    else if (lasting && demi_press_limit(w, dt) == DEM_OK && w->pressed.least < dt)
        demi_find(f, DEM_SEVERITY_ERROR, "dt is %g s, must be at most %g s for body %d, which is "
                  "pressed by %.3g contacts: use dt = 0", dt, w->pressed.least,
                  (int)w->bodies.slot[w->pressed.worst] + 1, w->press[w->pressed.worst].contacts);
    else if (lasting && dt < (double)a->dt/20)
        demi_find(f, DEM_SEVERITY_NOTE, "dt is %g s, %.3g times smaller than necessary (t_c/50 "
                  "= %g s): the run takes that much longer; use dt = 0", dt, (double)a->dt/dt,
                  (double)a->dt);
    if (rests > 0 && dt > rests)
        demi_find(f, w->desc.allow_large_dt ? DEM_SEVERITY_WARNING : DEM_SEVERITY_ERROR, "dt is "
                  "%g s, must be at most %.3g s for polyhedra as small as these to rest on each "
                  "other under gravity: use at most %.2g s", dt, rests, rests/1.5);
    if (w->effects.radius_min > 0 && fastest*dt > (double)w->effects.radius_min)
        demi_find(f, DEM_SEVERITY_ERROR, "at %.3g m/s a grain or wall moves %.3g radii of the "
                  "smallest grain in a step of %g s: they would pass through each other "
                  "undetected; use dt = 0", fastest, fastest*dt/(double)w->effects.radius_min, dt);
}
/* Estimates overlaps, divided by the radius, between two of the smallest grains of each material:
   in an impact at the speed a->speed, and under the weight of all grains. The weight is that of a
   bed that covers the area of the scene normal to gravity; each grain bears the weight on (2 r)^2
   of that area (not in planar worlds). Warns of what exceeds DEMI_OVERLAP_LIMIT, with the modulus
   that would keep it below: an overlap follows from the modulus to the power -2/5 (impact) or -2/3
   (weight) for Hertz's law, and from a given stiffness to the power -1/2 or -1. A stiffness that
   follows from a modulus is in proportion to its power 4/5. */
static void demi_check_overlaps(const dem_world *w, const dem_advice *a, demi_findings *f) {
    const double g = (double)demi_length(w->desc.gravity), v = (double)a->speed;
    const int hertz = demi_normal_is(w, DEMI_HERTZIAN);
    double lo[3] = {1e300, 1e300, 1e300}, hi[3] = {-1e300, -1e300, -1e300}, area = 0, mass = 0;
    const double n[3] = {(double)w->desc.gravity.x, (double)w->desc.gravity.y,
                         (double)w->desc.gravity.z};
    demi_grades grades;
    int i, k;
    if (!demi_laws_keep(w)) return;             /* an unknown law, or impulses: no overlaps */
    for (i = 0; i < w->bodies.count; i++) {
        if (w->bodies.inv_mass[i] > 0) mass += (double)w->bodies.mass[i];
        for (k = 0; k < 3; k++) {
            const double x = (double)w->bodies.pos[4*i + k], r = (double)demi_radius(w, i);
            lo[k] = DEMI_MIN(lo[k], x - r);
            hi[k] = DEMI_MAX(hi[k], x + r);
        }
    }
    for (k = 0; k < 3 && g > 0 && mass > 0; k++)
        area += fabs(n[k])/g*(hi[(k + 1)%3] - lo[(k + 1)%3])*(hi[(k + 2)%3] - lo[(k + 2)%3]);
    demi_grades_of(w, &grades);
    for (i = 0; i < w->material_count; i++) {
        const double r = grades.smallest[i], m = r > 0 ? demi_sphere_mass(w, i, r)/2 : 0;
        double deep[2] = {0, 0}, force, kn;
        dem_real coef[DEMI_COEFS];
        if (!(r > 0) || demi_ignores(w, i, i)) continue;
        demi_coefficients(w, i, i, r/2, m, m, 0, coef);
        kn = (double)coef[DEMI_KN];
        force = area > 0 && !w->desc.planar ? 4*r*r*mass*g/area : 0;
        deep[0] = hertz ? demi_pow(5*m*v*v/(4*kn), 0.4)/r : v*sqrt(m/kn)/r;
        deep[1] = (hertz ? demi_pow(force/kn, 2.0/3) : force/kn)/r;
        for (k = 0; k < 2; k++) {
            const int given = !hertz && w->materials[i].stiffness > 0;
            /* 1.05: so that the rounded value suffices, too */
            const double more = 1.05*demi_pow(deep[k]/DEMI_OVERLAP_LIMIT,
                                         k ? (hertz ? 1.5 : given ? 1 : 1.25)
                                           : hertz || !given ? 2.5 : 2);
            if (!(deep[k] > DEMI_OVERLAP_LIMIT)) continue;
            demi_find(f, DEM_SEVERITY_WARNING, "grains of material %d (radius %g m) will overlap "
                      "by %.2g of their radius %s%.3g %s; %s of %.2g %s would keep it below %g",
                      i + 1, r, deep[k],
                      k ? "under a weight of " : "at ", k ? force : v, k ? "N each" : "m/s",
                      given ? "a stiffness" : "a Young's modulus",
                      more*(double)(given ? w->materials[i].stiffness : w->materials[i].young),
                      given ? "N/m" : "Pa", DEMI_OVERLAP_LIMIT);
        }
    }
}

/* Checks of the scene alone come first; the last three need the neighbour list. If it cannot be
   built, the error message of the rebuild becomes a finding. */
DEM_API int dem_world_check(dem_world *w, dem_finding *findings, int capacity) {
    demi_findings f;
    dem_advice advice;
    if (demi_null(w, __func__, w, "world")) return 0;
    memset(&f, 0, sizeof f);
    f.to = findings;
    f.room = findings && capacity > 0 ? capacity : 0;
    demi_advise(w, &advice);
    demi_check_motion(w, &f);
    demi_check_motions(w, &advice, &f);
    demi_check_radii(w, &f);
    demi_check_digits(w, &f);
    demi_check_materials(w, &f);
    demi_check_walls(w, &f);
    demi_check_outside(w, &f);
    demi_check_enclosed(w, &f);
    demi_check_overlaps(w, &advice, &f);
    if (!w->bodies.count) return f.count;
    if (!w->stage.list_valid && demi_list_make(w, __func__) != DEM_OK) {
        demi_find(&f, DEM_SEVERITY_ERROR, "%.230s", w->error);
        return f.count;
    }
    demi_check_pairs(w, &f);
    demi_check_in_walls(w, &f);
    demi_check_step(w, &advice, &f);
    return f.count;
}

DEM_API int dem_world_check_print(dem_world *w, FILE *out) {
    static const char *const severities[] = {"note", "note", "warning", "error"};
    dem_finding findings[16];
    int i, n = dem_world_check(w, findings, 16);
    for (i = 0; out && i < n && i < 16; i++)
        demi_print(out, "%s: %s\n", severities[findings[i].severity], findings[i].text);
    return n;
}
