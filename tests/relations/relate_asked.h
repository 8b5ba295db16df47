/* relate_asked.h - relations that ask dem.h about one scene, where two runs with the same defect would agree: joints,
   samples of averages, outlets, slabs that are made of a world, functions that dem.h calls, places that are whole
   periods away. */
#ifndef REL_RELATE_ASKED_H
#define REL_RELATE_ASKED_H

/* Joined points coincide in the middle of the next step. Joints never add energy, and keep a gap where closing it would
   (docs/impulses.md), so the first step of one joint is asked, if it took energy. The turns of a step are foreseen to
   the third order of their angle. A joint between two fixed bodies holds nothing. Where nothing else acts, the force
   of a joint changes smoothly: second differences of 30 steps, once it has pulled for four, are below 0.04 of the
   largest force in all scenes that were drawn; 0.2 are allowed. */
CODE(joint_wrong, static double length(dem_vec3 v) { return sqrt(v.x*v.x + v.y*v.y + v.z*v.z); }
static int joint_jumps(dem_world *w, dem_joint j, dem_body a) {
    double jump = 0;
    double most = 0;
    dem_vec3 f[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    int k;
    for (k = 0; k < 30; k++) {
        dem_counters c;
        dem_joint_state s;
        dem_body_state p;
        if (dem_world_step(w, 1) != DEM_OK || dem_joint_get(w, j, &s) != DEM_OK) return 0;
        c = dem_counters_get(w);
        if (dem_body_get(w, a, &p) != DEM_OK || c.contacts || c.unsolved || s.power) return 0;
        if (c.dt*length(p.spin) > 0.1) return 0;
        f[0] = f[1];
        f[1] = f[2];
        f[2] = s.force;
        if (k < 4) continue;
        most = fmax(most, length(f[2]));
        jump = fmax(jump, length(dem_vec3_make(f[0].x - 2*f[1].x + f[2].x, f[0].y - 2*f[1].y + f[2].y,
            f[0].z - 2*f[1].z + f[2].z)) - 1e-6*p.mass/c.dt);
    }
    return jump > 0.2*most;
}
static int joint_wrong(dem_world *w, dem_joint j, dem_body a, dem_body b) {
    const dem_ledger l = dem_ledger_get(w);
    const dem_counters c = dem_counters_get(w);
    dem_joint_state s;
    dem_body_state p;
    dem_body_state q = {0};
    double turn, way;
    q.fixed = 1;
    if (dem_joint_get(w, j, &s) != DEM_OK || dem_body_get(w, a, &p) != DEM_OK) return 0;
    if (b.slot && dem_body_get(w, b, &q) != DEM_OK) return 0;
    if (p.fixed && q.fixed) return fabs(s.power) + length(s.force) + length(s.torque) > 0;
    if (dem_world_steps_get(w) != 1 || c.unsolved) return 0;
    turn = c.dt*(length(p.spin) + length(q.spin));
    way = c.dt*(length(p.velocity) + length(q.velocity));
    if (l.normal > 1e-3*(l.kinetic + l.rotational) && s.gap > 1e-4*p.radius + turn*turn*way) return 1;
    return joint_jumps(w, j, a);
})
/* An average is sampled at the first step from each multiple of its interval on, and late ones at once, up to its end
   (0: none). */
CODE(samples_wrong, static int samples_wrong(dem_world *w, dem_field f, double start, double end, double interval,
    int added) {
    const double dt = (double)dem_counters_get(w).dt;
    double last = -1;
    uint64_t n = 0;
    int k;
    dem_field_data d;
    if (!(interval > 0) || dem_field_get(w, f, &d) != DEM_OK) return 0;
    for (k = added + 1; k <= (int)dem_world_steps_get(w); k++) {
        const double m = floor((k*dt + 1e-6*dt - start)/interval);
        if (m <= last || (end > 0 && k*dt > end + 1e-6*dt)) continue;
        n++;
        last = m;
    }
    return d.samples != n;
})
/* The first number of a field of an op, or `otherwise` if it is not set. */
static double rel_or(const rel_op *op, const char *name, double otherwise) {
    const int f = rel_field_of(op->call, name);
    int i;
    for (i = 0; i < op->count; i++) if (op->set[i].field == f) return op->set[i].v[0];
    return otherwise;
}
static int rel_joints_of(rel_case *c, const rel_run *r) {
    int i;
    for (i = 0; i < c->s->count; i++) {
        const rel_op *op = &c->s->op[i];
        const int b = op->call == REL_JOINT ? (int)rel_or(op, "b", -1) : -1;
        dem_body none = {0, 0};
        dem_joint j;
        if (op->call != REL_JOINT || !r->made[i].id) continue;
        j.id = r->made[i].id;
        if (joint_wrong(r->w, j, r->made[(int)rel_or(op, "a", -1)].body, b < 0 ? none : r->made[b].body))
            return rel_broken(c, "joint %d does not hold together, or holds fixed bodies, after step %d", (int)j.id,
                              (int)dem_world_steps_get(r->w));
    }
    return REL_HOLDS;
}
/* Only the first joint and its bodies are left of a scene, so that nothing touches. */
static void rel_one_joint(rel_scene *s) {
    int i, joint = -1;
    for (i = 0; i < s->count; i++) if (s->op[i].call == REL_JOINT && joint < 0) joint = i;
    for (i = 0; i < s->count; i++) {
        const int call = s->op[i].call, a = (int)rel_or(&s->op[joint], "a", -1);
        const int b = (int)rel_or(&s->op[joint], "b", -1);
        if ((call > REL_UNION && call != REL_A_BODY && i != joint) || (call == REL_A_BODY && i != a && i != b))
            s->op[i].step = s->steps + 1;      /* never */
    }
    rel_put(&s->op[0], "ledger", 1);
    s->steps = s->marks = 1;
}
static int rel_joints(rel_case *c) {
    static rel_scene one;
    const rel_how how = {0};
    rel_run other;
    int i, result = REL_HOLDS;
    for (i = 0; i < c->s->count && c->s->op[i].call != REL_JOINT; i++) continue;
    if (!c->ran || i == c->s->count) return REL_SKIPPED;
    if (c->s->steps > 1) result = rel_joints_of(c, &c->base);
    if (result != REL_HOLDS) return result;
    rel_copy(&one, c->s);
    rel_one_joint(&one);
    if (rel_go(&other, &one, &how)) result = rel_joints_of(c, &other);
    rel_end(&other);
    return result;
}
/* dem_field_reset sets the number of samples to 0. */
static int rel_samples(rel_case *c) {
    int i, asked = 0;
    if (!c->ran || rel_scene_has(c->s, REL_FIELD_RESET)) return REL_SKIPPED;
    for (i = 0; i < c->s->count; i++) {
        const rel_op *op = &c->s->op[i];
        dem_field f;
        if (op->call != REL_FIELD || !c->base.made[i].id) continue;
        f.id = c->base.made[i].id;
        asked = 1;
        if (samples_wrong(c->base.w, f, rel_or(op, "start", 0), rel_or(op, "end", 0), rel_or(op, "interval", 0),
                          op->step))
            return rel_broken(c, "an average has another number of samples than multiples of its interval");
    }
    return asked ? REL_HOLDS : REL_SKIPPED;
}
/* ---- outlets ---- */
/* Goes step by step until a body leaves, or to step `most`. Returns the step; 0 if a call or a step fails. */
static int rel_go_until(rel_run *r, const rel_scene *s, int most) {
    const rel_how how = {0};
    int step;
    if (!rel_build(r, s, &how)) return 0;
    for (step = 1; step <= most; step++) {
        if (!rel_step(r, &how, 1)) return 0;
        if (dem_body_counts_get(r->w).left || step == most) return step;
        if (!rel_change(r, &how, step)) return 0;
    }
    return 0;
}
/* Is a place outside the region of an outlet? The box and `beyond` are in the frame of its wall (dem_outlet_desc). */
CODE(outlet_wrong, static int outlet_wrong(dem_world *w, dem_wall frame, const double *box, double beyond,
    const double *x) {
    dem_pose p = {{0, 0, 0}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}, {0, 0, 0}};
    double at[3] = {0, 0, 0};
    int k;
    int wrong;
    if (frame.id && dem_wall_pose_get(w, frame, &p) != DEM_OK) return 1;
    for (k = 0; k < 3; k++) {
        at[k] = p.rotation[k]*(x[0] - p.position.x);
        at[k] += p.rotation[3 + k]*(x[1] - p.position.y) + p.rotation[6 + k]*(x[2] - p.position.z);
    }
    wrong = hypot(at[0], at[1]) < beyond - 1e-9;
    for (k = 0; k < 3; k++) wrong |= at[k] < box[k] - 1e-9 || at[k] > box[3 + k] + 1e-9;
    return wrong;
})
/* What leaves through an outlet is in its region at the end of the step, as a run without the outlet shows. In a
   periodic world, a region in the frame of a wall can reach beyond the domain, where images of bodies are. */
static int rel_left(rel_case *c) {
    static rel_run with, without;
    static rel_scene open;
    const rel_set *box = 0;
    double beyond = 0;
    int i, n = 0, frame = -1, step, result = REL_HOLDS;
    dem_wall wall = {0};
    if (!c->ran) return REL_SKIPPED;
    rel_copy(&open, c->s);
    for (i = 0; i < open.count; i++)
        if (open.op[i].call == REL_OUTLET && !(rel_or(&open.op[i], "keep", 0) > 0)) {
            box = rel_find(&open.op[i], "box");
            beyond = rel_or(&open.op[i], "beyond", 0);
            frame = (int)rel_or(&open.op[i], "frame", -1);
            open.op[i].step = c->s->steps + 1; /* never */
            n++;
        }
    if (n != 1 || (frame >= 0 && rel_find(&open.op[0], "boundary"))) return REL_SKIPPED;
    memset(&without, 0, sizeof without);
    step = rel_go_until(&with, c->s, c->s->steps);
    if (step && dem_body_counts_get(with.w).left && rel_go_until(&without, &open, step) == step)
        for (i = 0; i < c->s->count && result == REL_HOLDS; i++) {
            dem_body_state b;
            double at[3];
            if (c->s->op[i].call != REL_A_BODY || !with.made[i].body.slot ||
                dem_body_get(with.w, with.made[i].body, &b) == DEM_OK ||
                dem_body_get(without.w, without.made[i].body, &b) != DEM_OK) continue;
            at[0] = (double)b.position.x; at[1] = (double)b.position.y; at[2] = (double)b.position.z;
            if (frame >= 0) wall.id = without.made[frame].id;
            if (outlet_wrong(without.w, wall, box->v, beyond, at))
                result = rel_broken(c, "at step %d a body leaves outside the outlet, at %.9g, %.9g, %.9g m", step,
                                    at[0], at[1], at[2]);
        }
    rel_end(&with);
    if (without.w) rel_end(&without);
    return result;
}
/* ---- slabs that are made of a world leave it as it is ---- */
/* Both runs change the friction of all pairs and change it back; in one of them slabs are made in between. */
static int rel_slabs_beside(rel_case *c) {
    static rel_run with, without;
    rel_how how = {0};
    int k, ran, result = REL_HOLDS;
    if (!c->ran || rel_has(c, "impulses")) return REL_SKIPPED;
    how.slabs = -1;
    ran = rel_go(&without, c->s, &how);
    how.slabs = -2;
    if (rel_go(&with, c->s, &how) != ran) result = rel_broken(c, "slabs that are made of a world end its run");
    for (k = 0; k < with.marks && k < without.marks && result == REL_HOLDS; k++)
        if (with.mark[k].hash != without.mark[k].hash)
            result = rel_broken(c, "slabs that are made of a world change its bits by step %d", with.mark[k].step);
    rel_end(&with);
    rel_end(&without);
    return result;
}
/* ---- functions that dem.h calls may not change the world, whichever call it is that calls them ---- */
static int rel_meddling(rel_case *c) {
    const rel_how how = {0};
    int i;
    if (!c->ran || rel_has(c, "impulses") || rel_given_in(&c->s->op[0], "law")) return REL_SKIPPED;
    rel_copy(&rel_own, c->s);
    rel_put(&rel_own.op[0], "law", rel_code_of("law_meddling"));
    rel_put(&rel_own.op[0], "law_memory", 3);
    rel_put(&rel_own.op[0], "law_vectors", 1);
    for (i = 0; i < rel_own.count; i++)
        if (rel_own.op[i].call == REL_FEED) rel_put(&rel_own.op[i], "inside", rel_code_of("inside_meddling"));
    rel_put(rel_more(&rel_own, REL_READ, rel_own.steps/2), "what", rel_code_of("steer"));
    if (!rel_instead(c)) return REL_SKIPPED;
    rel_copy(&rel_image, &rel_own);
    rel_put(&rel_image.op[rel_image.count - 1], "what", rel_code_of("meddle"));
    return rel_near(c, &rel_image, &how, &rel_same, "functions try to change gravity");
}
/* ---- whole periods ---- */
/* Does the body of an op follow a wall? */
static int rel_rides(const rel_scene *s, int body) {
    int i;
    for (i = 0; i < s->count; i++)
        if (s->op[i].call == REL_RAIL && (int)rel_or(&s->op[i], "body", -1) == body &&
            rel_or(&s->op[i], "wall", -1) >= 0) return 1;
    return 0;
}
/* Bodies and feeds that begin two periods away begin in the domain. A body on the rail of a wall moves as if it were
   part of it (dem_rail_desc.wall), so two periods farther from the axis of a rotation it moves on a larger circle:
   such bodies stay. */
static int rel_periods(rel_case *c) {
    static const char *const without[] = {"point joint", "hinge", "motor", "cell", 0};
    const rel_how how = {0};
    const rel_set *sides, *box;
    int i, k, result;
    if (!c->ran || rel_has_any(c, without)) return REL_SKIPPED;
    rel_copy(&rel_image, c->s);
    sides = rel_find(&rel_image.op[0], "boundary");
    box = rel_find(&rel_image.op[0], "domain");
    if (!sides || !box) return REL_SKIPPED;
    for (i = 0; i < rel_image.count; i++) {
        const int body = rel_image.op[i].call == REL_A_BODY && !rel_rides(c->s, i),
            feed = rel_image.op[i].call == REL_FEED;
        rel_set *x = body ? rel_find(&rel_image.op[i], "position") : feed ? rel_find(&rel_image.op[i], "box") : 0;
        for (k = 0; x && k < (feed ? 6 : 3); k++)
            if ((int)sides->v[k%3] == DEM_BOUNDARY_PERIODIC) x->v[k] += 2*(box->v[3 + k%3] - box->v[k%3]);
    }
    c->lists = 1;
    result = rel_near(c, &rel_image, &how, &rel_same, "two periods away");
    c->lists = 0;
    return result;
}
#endif
