/* relate_physics.h - relations of physics: what is conserved, counted, or at rest. */
#ifndef REL_RELATE_PHYSICS_H
#define REL_RELATE_PHYSICS_H
#include "edit.h"

static const int rel_bodies_alone[] = {REL_WORLD, REL_MATERIAL, REL_PAIR, REL_ELLIPSOID, REL_CLUSTER, REL_POLYHEDRON,
    REL_POLYGON, REL_UNION, REL_A_BODY, REL_JOINT, -1};
static const char *const rel_outside[] = {"gravity", "force", "body_force", "growth", 0};
/* Leaves out joints that hold bodies to walls or to space, and motors if `motors`. */
static void rel_leave_joints(rel_scene *s, int motors) {
    int i;
    for (i = s->count - 1; i > 0; i--) {
        const rel_set *b = i < s->count && s->op[i].call == REL_JOINT ? rel_find(&s->op[i], "b") : 0;
        if (i >= s->count || s->op[i].call != REL_JOINT) continue;
        if (!b || b->v[0] < 0 || (motors && rel_find(&s->op[i], "motor"))) rel_drop_ops(s, i, i + 1);
    }
}
/* ---- conserved ---- */
/* A copy on which nothing acts from outside, with the bodies on their way to each other. */
static void rel_leave_outside(rel_case *c, int periods /* and joints */) {
    static const char *const domain[] = {"domain", "boundary", 0};
    static const int joints[] = {REL_JOINT, -1};
    double centre[3] = {0, 0, 0}, far = 0;
    int i, k, n = 0;
    rel_copy(&rel_own, c->s);
    rel_leave_calls(&rel_own, rel_bodies_alone, 1);
    rel_leave_joints(&rel_own, 0);
    if (!periods) rel_leave_calls(&rel_own, joints, 0);
    rel_leave_fields(&rel_own, REL_WORLD, rel_outside);
    if (!periods || rel_has(c, "outflow")) rel_leave_fields(&rel_own, REL_WORLD, domain);
    for (i = 0; i < rel_own.count; i++) {
        const rel_set *x = rel_own.op[i].call == REL_A_BODY ? rel_find(&rel_own.op[i], "position") : 0;
        if (!x) continue;
        for (k = 0; k < 3; k++) centre[k] += x->v[k];
        n++;
    }
    for (k = 0; k < 3; k++) centre[k] /= n ? n : 1;
    for (i = 0; i < rel_own.count; i++) {
        const rel_set *x = rel_own.op[i].call == REL_A_BODY ? rel_find(&rel_own.op[i], "position") : 0;
        for (k = 0; k < 3 && x; k++) far = fmax(far, fabs(x->v[k] - centre[k]));
    }
    for (i = 0; i < rel_own.count; i++) {
        rel_set *v = rel_own.op[i].call == REL_A_BODY ? rel_find(&rel_own.op[i], "velocity") : 0;
        const rel_set *x = v ? rel_find(&rel_own.op[i], "position") : 0;
        for (k = 0; k < 3 && x && far > 0; k++) v->v[k] -= 0.3*(x->v[k] - centre[k])/far;
    }
}
/* Spheres instead of shapes. */
static void rel_round_bodies(rel_scene *s) {
    int i, j;
    for (i = 0; i < s->count; i++)
        for (j = 0; s->op[i].call == REL_A_BODY && j < s->op[i].count; j++)
            if (s->op[i].set[j].field == rel_field_of(REL_A_BODY, "shape")) {
                rel_drop_set(&s->op[i], j);
                rel_put(&s->op[i], "radius", 0.7e-3);
                break;
            }
}
/* Momentum, or angular momentum about the origin, stays. Each step rounds a velocity and a position of each body a few
   times; errors of all steps add up. The velocities of position Verlet are differences of positions of 1e-2 m,
   which are rounded to 1e-18 m, over steps of 1e-6 to 1e-5 s. */
static int rel_conserved(rel_case *c, int angular) {
    double all = 0;
    int k, e;
    if (!c->ran) return REL_SKIPPED;
    rel_leave_outside(c, !angular);
    if (angular && (rel_has(c, "impulses") || rel_has(c, "symplectic Euler"))) rel_round_bodies(&rel_own);
    if (!rel_instead(c) || !c->base.contacts) return REL_SKIPPED;
    if (angular && rel_has(c, "impulses") && (double)dem_counters_get(c->base.w).overlap_max > 1e-6) return REL_SKIPPED;
    for (k = 0; k < c->base.marks; k++) all = fmax(all, c->base.mark[k].most[angular]);
    c->allowed[0] = (rel_has(c, "position Verlet") ? 1e-11 : 10*DBL_EPSILON*c->s->steps)*all;
    for (k = 1; k < c->base.marks; k++)
        for (e = 0; e < 3; e++) {
            const dem_totals *a = &c->base.mark[0].totals, *b = &c->base.mark[k].totals;
            const double change = angular ? b->angular[e] - a->angular[e] : b->momentum[e] - a->momentum[e];
            if (!(fabs(change) <= c->allowed[0]))
                return rel_broken(c, "%smomentum along %c changes by %.3g of %.3g from step %d to %d (allowed: %.3g)",
                                  angular ? "angular " : "", 'x' + e, change, all, c->base.mark[0].step,
                                  c->base.mark[k].step, c->allowed[0]);
        }
    return REL_HOLDS;
}
static int rel_momentum(rel_case *c) { return rel_conserved(c, 0); }
/* With impulses, spheres and joints push both bodies in the middle of the gap between them; other shapes at points of
   their own, so that friction exerts a torque of a gap times its impulse: they are replaced by spheres. So they are
   with symplectic Euler, where the velocity is that of the end of a step, and the angular momentum of a shape that of
   its middle (docs/theory_surfaces.md). Joints close gaps by moving bodies that keep their velocities
   (docs/impulses.md); they are left out. Overlaps are closed so, too: scenes that have one are left out.
   Forward Euler moves bodies by the velocity before the force has acted: dt^2 v x F is lost in each step. */
static int rel_angular(rel_case *c) { return rel_has(c, "forward Euler") ? REL_SKIPPED : rel_conserved(c, 1); }
/* ---- counted ---- */
/* Numbers and masses of bodies by class: the classes are the radii in the scene. */
typedef struct rel_census {
    int classes, body_classes;                 /* body_classes: feeds add no bodies of other radii */
    double radius[DEM_CLASSES], begun_mass, removed_mass;
    int64_t begun[DEM_CLASSES], removed[DEM_CLASSES];
    uint64_t begun_total;
} rel_census;
static int rel_class_of(const rel_census *n, double radius) {
    int k, best = 0;
    for (k = 1; k < n->classes; k++) if (fabs(n->radius[k] - radius) < fabs(n->radius[best] - radius)) best = k;
    return best;
}
static void rel_class_add(rel_census *n, double radius) {
    int k;
    for (k = 0; k < n->classes && fabs(n->radius[k] - radius) > 1e-6*radius; k++) continue;
    if (k < n->classes) return;
    if (n->classes == DEM_CLASSES) { n->body_classes = 0; return; }
    for (k = n->classes++; k > 0 && n->radius[k - 1] > radius; k--) n->radius[k] = n->radius[k - 1];
    n->radius[k] = radius;
}
static void rel_census_begin(rel_census *n) {
    const rel_how how = {0};
    static rel_run r;
    int i, k;
    memset(n, 0, sizeof *n);
    n->body_classes = 1;
    if (rel_build(&r, &rel_own, &how)) {
        const dem_bodies b = dem_bodies_get(r.w);
        for (i = 0; i < b.count; i++) rel_class_add(n, (double)b.positions[4*i + 3]);
    }
    rel_end(&r);
    for (i = 0; i < rel_own.count; i++) {
        const rel_set *v;
        if (rel_own.op[i].call != REL_FEED) continue;
        if (rel_given_in(&rel_own.op[i], "shapes")) n->body_classes = 0;
        v = rel_given_in(&rel_own.op[i], "radius");
        for (k = 0; v && k < v->count; k++) rel_class_add(n, rel_own.pool[v->at + k]);
    }
    for (i = 0; i < rel_own.count && n->body_classes; i++) {
        rel_set *v;
        if (rel_own.op[i].call != REL_OUTLET || rel_own.pool_count + n->classes > REL_POOL) continue;
        rel_put(&rel_own.op[i], "class_count", n->classes);
        v = rel_slot(&rel_own.op[i], "radius");
        v->at = rel_own.pool_count;
        v->count = n->classes;
        memcpy(rel_own.pool + v->at, n->radius, (size_t)n->classes*sizeof *n->radius);
        rel_own.pool_count += n->classes;
    }
}
/* Compares at a step. Bodies that calls of this step remove are added to the census. */
static int rel_census_at(rel_case *c, rel_run *r, rel_census *n, int step) {
    const dem_bodies b = dem_bodies_get(r->w);
    const dem_body_counts all = dem_body_counts_get(r->w);
    int64_t more[DEM_CLASSES] = {0}, fed = 0, left = 0;
    double mass = 0, in = n->begun_mass, out = n->removed_mass;
    int i, k;
    if (all.inserted != all.present + all.removed + all.left || all.present != (uint64_t)b.count)
        return rel_broken(c, "at step %d: %d inserted, %d present (%d in arrays), %d removed, %d left", step,
                          (int)all.inserted,
                          (int)all.present, b.count, (int)all.removed, (int)all.left);
    for (i = 0; i < b.count; i++) {
        mass += (double)b.masses[i];
        more[rel_class_of(n, (double)b.positions[4*i + 3])]++;
    }
    if (!step) {
        for (k = 0; k < n->classes; k++) n->begun[k] = more[k];
        n->begun_mass = in = mass;
        n->begun_total = all.inserted;
    }
    for (k = 0; k < n->classes; k++) more[k] += n->removed[k] - n->begun[k];
    for (i = 0; i < c->s->count; i++) {
        dem_feed feed;
        dem_outlet outlet;
        dem_feed_state f;
        dem_outlet_state o;
        dem_body_state body;
        const rel_op *op = &c->s->op[i];
        feed.id = outlet.id = r->made[i].id;
        if (op->call == REL_FEED && dem_feed_get(r->w, feed, &f) == DEM_OK) {
            const rel_set *v = rel_given_in(op, "radius");
            for (k = 0; v && k < v->count; k++) more[rel_class_of(n, c->s->pool[v->at + k])] -= (int64_t)f.fed[k];
            fed += (int64_t)f.total;
            in += f.mass;
        }
        if (op->call == REL_OUTLET && dem_outlet_get(r->w, outlet, &o) == DEM_OK) {
            if (rel_given_in(op, "keep")) continue;
            for (k = 0; k < n->classes && n->body_classes; k++) more[k] += (int64_t)o.count[k];
            left += (int64_t)o.total;
            out += o.total_mass;
        }
        if (op->call == REL_REMOVE && op->step == step && step > 0) {
            const int at = (int)rel_given_in(op, "body")->v[0];
            if (dem_body_get(r->w, r->made[at].body, &body) != DEM_OK) continue;
            n->removed[rel_class_of(n, (double)body.radius)]++;
            n->removed_mass += (double)body.mass;
        }
    }
    /* by other ways */
    if (all.inserted != n->begun_total + (uint64_t)fed || (int64_t)all.left != left) return REL_HOLDS;
    for (k = 0; k < n->classes && n->body_classes; k++)
        if (more[k])
            return rel_broken(c, "at step %d: %d bodies of radius %.4g m more than inserted, less removed and left",
                              step,
                              (int)more[k], n->radius[k]);
    if (!(fabs(mass + out - in) <= (sizeof(dem_real) == sizeof(double) ? 1e-12 : 1e-6)*in))
        return rel_broken(c, "at step %d: %.17g kg inserted, %.17g kg present, %.17g kg removed or left", step, in,
                          mass, out);
    return REL_HOLDS;
}
/* Counts at every step, without what changes masses. The sums are rounded. */
static int rel_counted(rel_case *c) {
    static const int no[] = {REL_RESIZE, REL_REMOVE_SOME, REL_OUTLET_RESET, REL_FEED_SIZES, REL_FILL,
        REL_FILL_SHAPE, REL_SPHERES, -1};
    static const char *const fields[] = {"growth", 0};
    static rel_run r;
    static rel_census n;
    const rel_how how = {0};
    int step, result;
    if (!c->ran) return REL_SKIPPED;
    rel_copy(&rel_own, c->s);
    rel_leave_calls(&rel_own, no, 0);
    rel_leave_fields(&rel_own, REL_WORLD, fields);
    rel_census_begin(&n);
    c->s = &rel_own;                           /* no run of its twin is needed */
    if (!rel_build(&r, &rel_own, &how)) { rel_end(&r); return REL_SKIPPED; }
    result = rel_census_at(c, &r, &n, 0);
    for (step = 1; step <= rel_own.steps && result == REL_HOLDS; step++) {
        if (!rel_step(&r, &how, 1)) break;
        result = rel_census_at(c, &r, &n, step);
        if (result == REL_HOLDS && step < rel_own.steps && !rel_change(&r, &how, step)) break;
    }
    rel_end(&r);
    return result;
}
/* ---- energy ---- */
static double rel_dissipated(const dem_ledger *l) { return l->normal + l->slide + l->tangent + l->rolling; }
static double rel_stored(const dem_ledger *l) { return l->kinetic + l->rotational + l->elastic; }
/* The largest part of energy that a time step may create or lose. Springs: a contact begins or ends up to a step late,
   in which its force does work, first order in dt times the frequency of the contact; dem.h advises its duration.
   Impulses: contacts turn by the speed over the radius within a step. */
static double rel_step_error(const rel_case *c, const rel_run *r) {
    const double pi = 3.14159265358979, dt = (double)dem_counters_get(r->w).dt;
    const dem_bodies all = dem_bodies_get(r->w);
    double least = 1, speed = 0;
    dem_advice a;
    int i, k;
    memset(&a, 0, sizeof a);
    if (!rel_has(c, "impulses") && dem_step_advice_get(r->w, &a) == DEM_OK && a.contact_time > 0)
        return pi*dt/(double)a.contact_time;
    for (i = 0; i < all.count; i++) least = fmin(least, (double)all.positions[4*i + 3]);
    for (k = 0; k < r->marks; k++) {
        speed = fmax(speed, r->mark[k].speed);
        for (i = 0; i < r->mark[k].bodies; i++) {
            const double *o = r->mark[k].x + REL_PER_BODY*i + 6;
            speed = fmax(speed, least*sqrt(o[0]*o[0] + o[1]*o[1] + o[2]*o[2]));
        }
    }
    return speed*dt/least;
}
/* What the error of a step is compared with. */
static double rel_energy_of(const dem_ledger *l) {
    return rel_stored(l) + l->throughput + fabs(l->normal) + fabs(l->slide) + fabs(l->tangent) + fabs(l->rolling);
}
/* "The ledger closes if the normal force is proportional to these" (dem_contact.kn): not the forces of these laws, on
   bodies whose overlap does not grow by the approach. */
static int rel_books_apart(const rel_case *c) {
    static const char *const laws[] = {"capillary", "DMT", "JKR", "Luding", "Walton-Braun", "law across gaps", 0};
    static const char *const shapes[] = {"ellipsoids", "cubes", "rocks", "unions", "unions of ellipsoids",
        "unions of polyhedra", "polygons", "concave polygons", 0};
    return rel_has_any(c, laws) && rel_has_any(c, shapes);
}
/* True if a body feels two walls in one place after a step: contacts along one normal and as deep. "What springs gain
   when two walls in one place part" is in the residual (dem_ledger.growth). */
static int rel_walls_part(const rel_scene *s, const rel_how *how) {
    static dem_contact_info c[512];
    static rel_run r;
    int step, part = 0, ok = rel_build(&r, s, how);
    for (step = 1; ok && !part && step <= s->steps; step++) {
        int n, i, k;
        if (!rel_step(&r, how, 1)) break;
        n = dem_contacts_get(r.w, c, 512);
        for (i = 0; i < n && i < 512 && !part; i++)
            for (k = 0; k < i && c[i].wall && !part; k++)
                part = c[k].wall && c[k].wall != c[i].wall && c[k].a.slot == c[i].a.slot &&
                    fabs((double)(c[k].overlap - c[i].overlap)) < 0.01*(double)c[i].overlap &&
                    (double)(c[k].normal.x*c[i].normal.x + c[k].normal.y*c[i].normal.y + c[k].normal.z*c[i].normal.z)
                        > 1 - 1e-5;
        if (step < s->steps && !rel_change(&r, how, step)) break;
    }
    rel_end(&r);
    return part;
}
/* Runs a scene with a ledger, if its books can close. share: see rel_step_error. */
static int rel_books(rel_case *c, rel_run *r, const rel_how *with, double *share) {
    if (!c->ran || rel_has(c, "forward Euler") || rel_books_apart(c)) return 0;
    rel_copy(&rel_own, c->s);
    rel_fit_units(&rel_own);
    if (!rel_instead(c)) return 0;
    if (!rel_go(r, c->s, with)) { rel_end(r); return 0; }
    *share = rel_step_error(c, r);
    return 1;
}
static int rel_energy(rel_case *c) {
    rel_how with = {0};
    static rel_run other;
    int k, result = REL_HOLDS;
    double share;
    with.ledger = 1;
    if (!rel_books(c, &other, &with, &share)) return REL_SKIPPED;
    /* "what springs held on a grain that an outlet or an outflow boundary removes" is in the residual (dem_ledger) */
    for (k = 0; k < other.marks && result == REL_HOLDS && !(rel_leaves(c) && other.mark[k].left); k++) {
        const dem_ledger *l = &other.mark[k].ledger;
        const double all = rel_energy_of(l);
        c->allowed[0] = share*all;
        if (!(fabs(l->residual) <= share*all))
            result = rel_broken(c, "the ledger's residual is %.3g J of %.3g J at step %d (allowed: %.3g J)",
                                l->residual, all,
                                other.mark[k].step, share*all);
    }
    rel_end(&other);
    return result == REL_BROKEN && rel_walls_part(c->s, &with) ? REL_SKIPPED : result;
}
/* Energy that is neither supplied nor stored is dissipated: what is stored never exceeds what was supplied, less what
   was removed, but for the error of the step; and no row of what is dissipated decreases. The spring slider and the
   remainder slider store energy that no slip supplied (dem_slider): with them, slide and tangent are not judged.
   A step whose sweeps did not reach the tolerance (dem_counters.unsolved) may gain energy, for instance of a body
   wedged between two walls, where friction increases the impulses without bound: nor are it and later steps judged. */
static int rel_no_gain(rel_case *c) {
    static const char *const sliders[] = {"spring slider", "remainder slider", 0};
    const int free = !rel_has_any(c, sliders);
    static rel_run other;
    rel_how with = {0};
    int k, result = REL_HOLDS;
    double share;
    with.ledger = 1;
    if (!rel_books(c, &other, &with, &share)) return REL_SKIPPED;
    for (k = 0; k < other.marks && result == REL_HOLDS && !other.mark[k].unsolved; k++) {
        const dem_ledger *l = &other.mark[k].ledger, *was = &other.mark[k ? k - 1 : 0].ledger;
        const double all = rel_energy_of(l), lost = l->normal + l->rolling + (free ? l->slide + l->tangent : 0);
        const double gain = l->residual + l->unknown - lost;
        const double more[] = {l->normal - was->normal, free ? l->slide - was->slide : 0,
            free ? l->tangent - was->tangent : 0, l->rolling - was->rolling};
        static const char *const names[] = {"normal", "slide", "tangent", "rolling"};
        int e;
        c->allowed[0] = share*all;
        if (!(gain <= share*all))
            result = rel_broken(c, "%.3g J of %.3g J were created by step %d (allowed: %.3g J)", gain, all,
                                other.mark[k].step, share*all);
        for (e = 0; e < 4 && result == REL_HOLDS; e++)
            if (!(more[e] >= -share*all))
                result = rel_broken(c, "%.3g J of %.3g J came back from what is dissipated (%s) by step %d", -more[e],
                                    all, names[e],
                                    other.mark[k].step);
    }
    rel_end(&other);
    return result == REL_BROKEN && rel_walls_part(c->s, &with) ? REL_SKIPPED : result;
}
/* ---- half the time step ---- */
/* Compared over many scenes at the end of a run: relations.c calls rel_halved_end. The sums stay in its log. */
typedef struct rel_halves { int scenes, more; } rel_halves;
static rel_halves rel_halved_all;
typedef struct rel_trace { int count; uint64_t contacts[1024]; double residual[1024], all[1024]; } rel_trace;
static uint64_t rel_contact_set(const dem_world *w) {
    static dem_contact_info all[2048];
    const int n = dem_contacts_get(w, all, 2048);
    uint64_t sum = 0;
    int i;
    for (i = 0; i < n && i < 2048; i++) {
        rel_rng r;
        const uint32_t a = (uint32_t)all[i].a.slot,
            b = all[i].wall ? 0x80000000u + (uint32_t)all[i].wall : (uint32_t)all[i].b.slot;
        const double f = (double)all[i].force.x*(double)all[i].force.x + (double)all[i].force.y*(double)all[i].force.y +
                         (double)all[i].force.z*(double)all[i].force.z;
        if (!(f > 0) || all[i].further) continue;
        r.s = a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
        sum += rel_next(&r);                   /* whatever the order */
    }
    return sum;
}
static int rel_traced(rel_trace *t, const rel_scene *s, int per) {
    static rel_run r;
    rel_how how = {0};
    int step, ok;
    how.ledger = 1;
    t->count = 0;
    ok = rel_build(&r, s, &how);
    for (step = 1; ok && step <= s->steps && t->count < 1024; step++) {
        if (!rel_step(&r, &how, 1)) break;
        if (step%per == 0) {
            const dem_ledger l = dem_ledger_get(r.w);
            t->contacts[t->count] = rel_contact_set(r.w);
            t->residual[t->count] = fabs(l.residual);
            t->all[t->count++] = rel_energy_of(&l);
        }
        if (step < s->steps && !rel_change(&r, &how, step)) break;
    }
    rel_end(&r);
    return ok;
}
/* The residual falls with dt, by half or to a quarter. It is compared until other bodies touch: from the first of three
   steps with other contacts in both runs; one or two may differ where a contact begins. A residual that is rounding
   does not count, nor one before anything touched. */
static int rel_halved(rel_case *c) {
    static rel_trace a, b;
    int i, k, n, same, touched = 0;
    if (!c->ran || rel_has(c, "forward Euler") || rel_has(c, "own law") || rel_books_apart(c) || c->s->steps > 1000)
        return REL_SKIPPED;
    rel_copy(&rel_own, c->s);
    for (i = 0; i < rel_own.count; i++) rel_own.op[i].step *= 2;
    rel_own.steps *= 2;
    rel_find(&rel_own.op[0], "dt")->v[0] /= 2;
    if (!rel_traced(&a, c->s, 1) || !rel_traced(&b, &rel_own, 2)) return REL_SKIPPED;
    n = a.count < b.count ? a.count : b.count;
    for (k = same = 0; k < n; k++) {
        if (a.contacts[k] == b.contacts[k]) same = k + 1;
        else if (k - same >= 2) break;
    }
    for (k = 0; k < same; k++) touched |= a.contacts[k] != 0;
    if (!touched || !(a.residual[same - 1] > 1e-12*a.all[same - 1])) return REL_SKIPPED;
    rel_halved_all.scenes++;
    rel_halved_all.more += b.residual[same - 1] > 0.55*a.residual[same - 1];
    return REL_HOLDS;
}
/* The median is at most a half (0.55 with an error of second order, in which dt times the frequency is 0.06), unless
   chance has drawn three standard deviations more. */
static int rel_halved_end(void) {
    const double n = rel_halved_all.scenes;
    return rel_halved_all.more <= n/2 + 1.5*sqrt(n);
}
/* ---- at rest ---- */
static const int rel_bodies_in_walls[] = {REL_WORLD, REL_MATERIAL, REL_PAIR, REL_ELLIPSOID, REL_CLUSTER, REL_POLYHEDRON,
    REL_POLYGON, REL_UNION, REL_A_BODY, REL_JOINT, REL_PLANE, REL_CYLINDER, REL_REVOLVED, REL_CONE, REL_MESH,
        REL_PROFILE,
    REL_GRAINS, REL_SIEVE, -1};
enum { REL_FEW = 5, REL_MOST_STEPS = 60000 };
static const double rel_settling = 0.12, rel_resting = 1e-5;           /* s, m/s */
/* A copy with at most eight bodies, gravity, walls at rest, and damping that ends (settle in codes.h). */
static int rel_leave_motion(rel_case *c, double time) {
    const double dt = rel_find((rel_op *)&c->s->op[0], "dt")->v[0], g = 9.81;
    const int flat = rel_has(c, "cubes") || rel_has(c, "rocks"), sieve = rel_has(c, "sieve");
        /* which take long */
    int i, n = 0;
    rel_copy(&rel_own, c->s);
    rel_leave_calls(&rel_own, rel_bodies_in_walls, 1);
    rel_leave_joints(&rel_own, 1);
    rel_leave_fields(&rel_own, REL_WORLD, rel_outside);
    for (i = 1; i < rel_own.count; i++)
        if (rel_own.op[i].call == REL_A_BODY && ++n > REL_FEW) { rel_drop_ops(&rel_own, i, i + 1); i--; }
    for (i = 1; i < rel_own.count; i++) {
        rel_set *v = rel_own.op[i].call == REL_A_BODY ? rel_find(&rel_own.op[i], "velocity") : 0;
        int k;
        rel_own.op[i].step = 0;
        for (k = 0; k < 3 && v; k++) v->v[k] /= 4;
    }
    if (rel_has(c, "planar")) rel_put3(&rel_own.op[0], "gravity", 0, -g, 0);
    else rel_put3(&rel_own.op[0], "gravity", 0, 0, -g);
    rel_put(&rel_own.op[0], "body_force", rel_code_of("settle"));
    rel_own.marks = REL_MARKS_MOST;
    rel_own.steps = REL_MARKS_MOST*(int)ceil(time/dt/REL_MARKS_MOST);
    return rel_walls(&rel_own) && rel_own.steps <= REL_MOST_STEPS/(flat ? sieve ? 60 : 6 : 1);
}
/* The mean force on all walls is the weight of the bodies that rest on them: what is left of the momentum is that of
   speeds below those of rest. */
static int rel_weight(rel_case *c) {
    static rel_run r;
    const rel_how how = {0};
    int e, result = REL_HOLDS;
    if (!c->ran || !rel_leave_motion(c, rel_settling*1.1)) return REL_SKIPPED;
    if (!rel_go(&r, &rel_own, &how)) { rel_end(&r); return REL_SKIPPED; }
    {
        const rel_mark *a = &r.mark[REL_MARKS_MOST - 2], *b = a + 1;
        const double dt = (double)dem_counters_get(r.w).dt, time = (b->step - a->step)*dt, weight = 9.81*b->totals.mass;
        const int down = rel_has(c, "planar") ? 1 : 2;
        c->s = &rel_own;
        c->allowed[0] = 2*rel_resting*b->totals.mass/time + 1e-9*weight;
        if (!(a->speed <= rel_resting) || !(b->speed <= rel_resting) || !b->bodies) result = REL_SKIPPED;
        for (e = 0; e < 3 && result == REL_HOLDS; e++) {
            const double force = (b->impulse[e] - a->impulse[e])/time, want = e == down ? -weight : 0;
            if (!(fabs(force - want) <= c->allowed[0]))
                result = rel_broken(c, "bodies with weight %.9g N exert %.9g N along %c on walls (%.3g N allowed)",
                                    weight, force,
                                    'x' + e, c->allowed[0]);
        }
    }
    rel_end(&r);
    return result;
}
/* Scenes that are known to break a relation: with all of these rows. */
typedef struct rel_known { const char *relation, *rows[4], *why; } rel_known;
static const rel_known rel_known_breaks[] = {
    {"rest", {"impulses", "cubes", 0}, "blocks stacked by impulses creep"},
    {"rest", {"impulses", "rocks", 0}, "blocks stacked by impulses creep"}
};
/* What came to rest under damping stays there ten times as long without it. A speed v that damping of 1000/s leaves can
   come from an acceleration of 1000 v, for instance on a slope, where a ball rolls off later. */
static int rel_rest(rel_case *c) {
    static rel_run r;
    const rel_how how = {0};
    int k, result = REL_HOLDS;
    if (!c->ran || !rel_leave_motion(c, 11*rel_settling)) return REL_SKIPPED;
    c->s = &rel_own;
    if (!rel_build(&r, &rel_own, &how)) result = REL_SKIPPED;
    for (k = 1; k <= REL_MARKS_MOST && result == REL_HOLDS; k++) {
        if (!rel_step(&r, &how, rel_own.steps/REL_MARKS_MOST)) result = REL_SKIPPED;
        else rel_put_mark(&r, k*rel_own.steps/REL_MARKS_MOST);
        if (result == REL_SKIPPED || (k == 1 && !(r.mark[0].speed <= rel_resting))) { result = REL_SKIPPED; break; }
        c->allowed[0] = rel_resting + r.mark[0].speed*(1 + 1000*rel_settling*(k - 1));
        if (!(r.mark[k - 1].speed <= c->allowed[0]))
            result = rel_broken(c, "%.3g m/s at rest at step %d, a body moves with %.3g m/s at step %d (%.3g allowed)",
                                r.mark[0].speed, r.mark[0].step, r.mark[k - 1].speed, r.mark[k - 1].step,
                                c->allowed[0]);
    }
    rel_end(&r);
    return result;
}
/* Is a scene known to break this relation? */
static const char *rel_known_break(const rel_case *c, const char *relation) {
    int i;
    for (i = 0; i < (int)(sizeof rel_known_breaks/sizeof *rel_known_breaks); i++)
        if (!strcmp(rel_known_breaks[i].relation, relation) && rel_has(c, rel_known_breaks[i].rows[0]) &&
            rel_has(c, rel_known_breaks[i].rows[1])) return rel_known_breaks[i].why;
    return 0;
}
#endif
