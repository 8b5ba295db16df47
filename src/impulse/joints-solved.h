/* ---------------------------------------------------------------------------------------------
   >>joints-solved
   Direct solution of the joint constraints of >>joints: sparse block LDL' factorisation. This part
   has the elimination order, the blocks and their factor, sweeps, the energy guard and the results
   (forces, power). A rod is a joint in one step. A node is a node of the system: a body or a joint.
   Owns rods, nodes, links, rows and blocks of w->solver; writes w->joints, and displaces bodies to
   close gaps. Tests: tests/impulse/test_joints.c, tests/hard/hard_joints.c.
   --------------------------------------------------------------------------------------------- */

/* Adds node `to` at the front of a linked list. Returns 0 if memory ran out. */
static int demi_node_link(dem_world *w, int32_t *list, int to) {
    demi_solver *s = &w->solver;
    if (!DEMI_GROW(w, s->links, (size_t)s->link_count + 1)) return 0;
    s->links[s->link_count].to = to;
    s->links[s->link_count].next = *list;
    *list = s->link_count++;
    return 1;
}
/* Adds the node of a body (rod -1) or of a joint (mover -1), and returns its index. */
static int demi_node_add(demi_solver *s, int mover, int rod) {
    demi_joint_node *k = s->nodes + s->node_count;
    memset(k, 0, sizeof *k);
    k->mover = mover;
    k->rod = rod;
    k->links = k->waiting = k->rank = k->mark = -1;
    k->group = s->node_count;
    return s->node_count++;
}
/* Returns the root of a node's group of connected nodes (union-find with path halving). */
static int demi_node_group(demi_solver *s, int node) {
    while (s->nodes[node].group != node)
        node = s->nodes[node].group = s->nodes[s->nodes[node].group].group;
    return node;
}
/* True if a node may be eliminated. A body always may. A joint may once one of its bodies was
   eliminated in its favour (`paid`; a body pays for one joint), or both were: only then does its
   pivot contain the compliance of a body. */
static int demi_node_ready(const demi_solver *s, const demi_joint_node *k) {
    int e, gone = 1;
    if (k->rod < 0 || k->paid) return 1;
    for (e = 0; e < 2; e++) {
        const int end = s->rods[k->rod].ends[e];
        gone &= end < 0 || s->nodes[end].rank >= 0;
    }
    return gone;
}
/* Symbolic elimination of one node: its remaining neighbours become its column of the factor, and
   neighbours of each other (fill-in). Returns 0 if memory ran out. */
static int demi_node_eliminate(dem_world *w, int node, int rank) {
    demi_solver *s = &w->solver;
    const int first = s->row_count;
    int i, j, e, paid = s->nodes[node].rod >= 0;
    s->nodes[node].rank = rank;
    s->nodes[rank].order = node;
    s->nodes[node].first = first;
    for (e = s->nodes[node].links; e >= 0; e = s->links[e].next) {
        const int to = s->links[e].to;
        if (s->nodes[to].rank >= 0) continue;
        if (!DEMI_GROW(w, s->rows, (size_t)s->row_count + 1)) return 0;
        s->rows[s->row_count++] = to;
        if (paid || s->nodes[to].rod < 0 || s->nodes[to].paid ||
            (s->rods[s->nodes[to].rod].ends[0] != node &&
             s->rods[s->nodes[to].rod].ends[1] != node)) continue;
        s->nodes[to].paid = paid = 1;
    }
    s->nodes[node].count = s->row_count - first;
    for (i = first; i < s->row_count; i++) {
        const int a = s->rows[i];
        for (e = s->nodes[a].links; e >= 0; e = s->links[e].next)
            s->nodes[s->links[e].to].mark = a;
        s->nodes[a].degree--;
        for (j = first; j < s->row_count; j++) {
            const int b = s->rows[j];
            if (b == a || s->nodes[b].mark == a) continue;
            if (!demi_node_link(w, &s->nodes[a].links, b)) return 0;
            s->nodes[a].degree++;
        }
        if (demi_node_ready(s, s->nodes + a) &&
            !demi_node_link(w, &s->nodes[s->nodes[a].degree].waiting, a)) return 0;
    }
    return 1;
}
/* Minimum-degree ordering: eliminates the node with the fewest neighbours first. A tree is
   eliminated from its leaves to its root without fill-in; loops cause little. Returns 0 if memory
   ran out. */
static int demi_nodes_order(dem_world *w) {
    demi_solver *s = &w->solver;
    int i, rank = 0, d;
    for (i = s->node_count - 1; i >= 0; i--)
        if (s->nodes[i].rod < 0 &&
            !demi_node_link(w, &s->nodes[s->nodes[i].degree].waiting, i)) return 0;
    for (d = 0; d < s->node_count; ) {
        demi_joint_node *k = s->nodes + d;
        const int e = k->waiting;
        if (e < 0) { d++; continue; }
        k->waiting = s->links[e].next;
        i = s->links[e].to;
        if (s->nodes[i].rank >= 0 || s->nodes[i].degree != d) continue;
        if (!demi_node_eliminate(w, i, rank++)) return 0;
        d = 0;
    }
    return 1;
}
/* Removes joints that have lost a body or their wall, then builds the system of this step: rods,
   nodes, groups, elimination order and memory for the blocks. Returns 0 if memory ran out. */
static int demi_joints_room(dem_world *w) {
    demi_solver *s = &w->solver;
    const size_t bodies = (size_t)w->bodies.count;
    int i, n = 0, e;
    for (i = 0; i < w->joint_count; i++)
        if (demi_joint_alive(w, w->joints + i)) {
            if (n < i) w->joints[n] = w->joints[i];
            n++;
        }
    w->joint_count = n;
    s->node_count = s->link_count = s->row_count = 0;
    if (!n) return 1;
    if (!DEMI_GROW(w, s->rods, (size_t)n) || !DEMI_GROW(w, s->joined, bodies) ||
        !DEMI_GROW(w, s->node_of, bodies) || !DEMI_GROW(w, s->nodes, 3*(size_t)n)) return 0;
    for (i = 0; i < w->bodies.count; i++) s->joined[i] = s->node_of[i] = -1;
    for (i = 0; i < n; i++) {
        const dem_joint_desc *d = &w->joints[i].desc;
        demi_rod *r = s->rods + i;
        const int body[2] = {demi_body_find(w, d->a),
                             d->b.slot ? demi_body_find(w, d->b) : -1};
        memset(r, 0, sizeof *r);
        r->a = body[0];
        r->b = body[1] >= 0 ? body[1] : w->bodies.count + w->persistent_first[DEMI_DOMAINS] + i;
        for (e = 0; e < 2; e++) {
            r->ends[e] = -1;
            if (body[e] < 0) continue;
            r->next[e] = s->joined[body[e]];
            s->joined[body[e]] = i;
            if (!(w->bodies.inv_mass[body[e]] > 0)) continue;
            if (s->node_of[body[e]] < 0) s->node_of[body[e]] = demi_node_add(s, body[e], -1);
            r->ends[e] = s->node_of[body[e]];
            r->rows = demi_joint_rows(d->kind) + (d->motor == DEM_MOTOR_SPEED);
        }
        if (!r->rows) continue;
        r->node = demi_node_add(s, -1, i);
        for (e = 0; e < 2; e++) {
            const int end = r->ends[e];
            if (end < 0) continue;
            s->nodes[demi_node_group(s, r->node)].group = demi_node_group(s, end);
            if (!demi_node_link(w, &s->nodes[end].links, r->node) ||
                !demi_node_link(w, &s->nodes[r->node].links, end)) return 0;
            s->nodes[end].degree++;
            s->nodes[r->node].degree++;
        }
    }
    for (i = 0; i < s->node_count; i++) {
        demi_joint_node *group = s->nodes + demi_node_group(s, i);
        const demi_rod *r = s->rods + s->nodes[i].rod;
        group->excess += s->nodes[i].rod < 0 ? -1 : 1;
        group->grounded |= s->nodes[i].rod >= 0 && (r->ends[0] < 0 || r->ends[1] < 0);
    }
    return demi_nodes_order(w) &&
        DEMI_GROW(w, s->blocks, 36*((size_t)s->node_count + (size_t)s->row_count));
}

/* --- the system of one step --- */

/* One end of a joint in the world frame: arm from the body, m; joined point, m; axis, unit. */
typedef struct demi_rod_end { dem_vec3 arm, point, axis; } demi_rod_end;
/* Returns the time, s, between the contact detections of this step and the next. A body that has
   made no step since it was set is at the beginning of the step in the first, not in the middle. */
static dem_real demi_node_ahead(const dem_world *w, int body) {
    return w->solver.dt*(body >= w->bodies.count || w->bodies.went[body] ? 1 : DEM_R(1.5));
}
/* Returns the velocity, m/s, of point `at` in the frame of a wall that has this pose. */
static dem_vec3 demi_held_speed(const dem_pose *pose, dem_vec3 at) {
    return demi_surface_at(pose, demi_add(pose->position, demi_rotate(pose->rotation, at)));
}
/* Returns the way, m, of such a point in `by`, s; mid: pose midway. Exact for a steady screw. */
static dem_vec3 demi_held_way(const dem_pose *mid, dem_vec3 at, dem_real by) {
    const dem_vec3 way = demi_scale(demi_held_speed(mid, at), by);
    const dem_vec3 half = demi_scale(mid->spin, by/2);
    const dem_real x = demi_length(half), chord = x > 0 ? (dem_real)demi_sin((double)x)/x : 1;
    const dem_real along = x > 0 ? demi_dot(way, half)/(x*x) : 0;
    return demi_add(demi_scale(way, chord), demi_scale(half, (1 - chord)*along));
}
/* Returns end 0 (a) or 1 (b) of a joint: as it is now, or (`ahead`) at the next detection, with the
   velocities of the impulses found so far. */
static demi_rod_end demi_rod_end_of(const dem_world *w, int joint, int end, int ahead) {
    const demi_joint *j = &w->joints[joint];
    const demi_solver *s = &w->solver;
    const demi_rod *r = s->rods + joint;
    const int body = end ? r->b : r->a;
    const dem_real by = ahead ? demi_node_ahead(w, body) : 0;
    demi_rod_end o;
    if (body < w->bodies.count) {
        const dem_quat q = ahead && r->ends[end] >= 0 ? s->nodes[r->ends[end]].turned
            : demi_quat_at(w->bodies.orient + 4*body);
        o.arm = dem_quat_rotate(q, j->arm[end]);
        o.axis = dem_quat_rotate(q, j->axis[end]);
        o.point = demi_add(demi_add(demi_at(w->bodies.pos + 4*body), o.arm),
                           demi_scale(demi_at(s->movers[body].v), by));
    } else {
        o.arm = demi_v(0, 0, 0);
        o.point = j->arm[end];
        o.axis = j->axis[end];
        if (j->desc.wall.id) {
            const demi_wall *wall = &w->walls[demi_wall_place(j->desc.wall)];
            const dem_pose *pose = &wall->pose;
            o.point = demi_add(demi_add(pose->position, demi_rotate(pose->rotation, o.point)),
                               demi_held_way(&wall->ahead, o.point, by));
            o.axis = dem_quat_rotate(demi_quat_exp(demi_scale(wall->ahead.spin, by)),
                                     demi_rotate(pose->rotation, o.axis));
        }
    }
    return o;
}
/* Computes the velocity of a relative to b in the six rows, m/s and rad/s. */
static void demi_rod_velocity(const demi_solver *s, const demi_rod *r, dem_real *u) {
    const demi_mover *a = s->movers + r->a, *b = s->movers + r->b;
    const dem_vec3 turn = demi_sub(demi_at(a->w), demi_at(b->w));
    const dem_vec3 va = demi_add(demi_at(a->v), demi_cross(demi_at(a->w), r->arm[0]));
    const dem_vec3 vb = demi_add(demi_at(b->v), demi_cross(demi_at(b->w), r->arm[1]));
    int k;
    demi_put(u, demi_sub(va, vb));
    for (k = 3; k < 6; k++) u[k] = demi_dot(turn, r->along[k - 3]);
}
/* Returns the angular impulse on a of the impulses p in the rows of spin, N m s. */
static dem_vec3 demi_rod_twist(const demi_rod *r, const dem_real *p) {
    dem_vec3 l = demi_v(0, 0, 0);
    int k;
    for (k = 3; k < 6; k++) l = demi_add(l, demi_scale(r->along[k - 3], p[k]));
    return l;
}
/* Applies impulses p in the rows of velocity, and an angular impulse l, to a; the opposite to b. */
static void demi_rod_apply(const dem_world *w, const demi_rod *r, const dem_real *p, dem_vec3 l) {
    const demi_solver *s = &w->solver;
    const int shaped = w->bodies.shaped > 0;
    const dem_vec3 f = demi_at(p), back = demi_scale(f, -1);
    demi_mover_push(s, r->a, f, demi_add(l, demi_cross(r->arm[0], f)), shaped);
    demi_mover_push(s, r->b, back, demi_sub(demi_cross(r->arm[1], back), l), shaped);
}
/* Returns the length that compares rotations with displacements, m: the smaller radius of the two
   bodies. It also limits how far a gap is closed in a step; gaps are larger only after the user has
   moved a body. */
static dem_real demi_rod_size(const dem_world *w, const demi_rod *r) {
    const dem_real a = demi_radius(w, r->a);
    return r->b < w->bodies.count ? DEMI_MIN(a, demi_radius(w, r->b)) : a;
}
/* True if row k of a joint is in force. Planar worlds have no tilt; a motor at its limit no row. */
static int demi_rod_row(const dem_world *w, const demi_rod *r, int k) {
    return k < r->rows && (k < 3 || (k < 5 ? !w->desc.planar : !r->stuck));
}
/* Computes row k of the Jacobian at one end of a joint: the factors of velocity and spin there. */
static void demi_rod_jacobian(const dem_world *w, const demi_rod *r, int end, int k, double *row) {
    static const dem_vec3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const int body = end ? r->b : r->a;
    const double sign = end ? -1 : 1;
    const dem_vec3 l = k < 3 ? demi_cross(r->arm[end], unit[k]) : r->along[k - 3];
    const dem_real turn[3] = {l.x, l.y, l.z};
    int i;
    for (i = 0; i < 3; i++) {
        const int turns = (w->bodies.inv_inertia[body] > 0 || demi_shape_of(w, body)) &&
            (i == 2 || !w->desc.planar);
        row[i] = i == k ? sign : 0;
        row[3 + i] = turns ? sign*(double)turn[i] : 0;
    }
}
/* Computes the 6 x 6 matrix of mass, kg, and inertia, kg m2, of a body; 1 if it cannot rotate. */
static void demi_node_mass(const dem_world *w, int body, double *m) {
    const double inv = (double)w->bodies.inv_inertia[body];
    int i, k;
    memset(m, 0, 36*sizeof *m);
    for (i = 0; i < 3; i++) {
        m[7*i] = 1/(double)w->bodies.inv_mass[body];
        m[7*(3 + i)] = inv > 0 ? 1/inv : 1;
    }
    if (!w->bodies.shaped || !w->bodies.shape[body]) return;
    if (w->desc.planar) {
        m[35] = 1/(double)w->solver.tensors[6*body + 2];
        return;
    }
    for (i = 0; i < 3; i++) {
        const dem_vec3 y = demi_body_turning(w, body, demi_v(i == 0, i == 1, i == 2));
        const dem_real column[3] = {y.x, y.y, y.z};
        for (k = 0; k < 3; k++) m[6*(3 + k) + 3 + i] = (double)column[k];
    }
}
/* Inverts a symmetric 6 x 6 matrix in place, which is `sign` times a positive definite one, by
   Cholesky factorisation. `least` (may be null): lower bounds of the squared diagonal of the
   factor. */
static void demi_block_invert(double *m, double sign, const dem_real *least) {
    double f[36], inv[36];
    int i, j, k;
    for (i = 0; i < 6; i++)
        for (j = i; j < 6; j++) {
            double sum = sign*m[6*j + i];
            for (k = 0; k < i; k++) sum -= f[6*i + k]*f[6*j + k];
            f[6*j + i] = j > i ? sum*f[7*i] : 1/sqrt(DEMI_MAX(sum, least ? (double)least[i]
                                                                        : DBL_MIN));
        }
    for (i = 0; i < 6; i++) {                   /* of f; its diagonal is inverted already */
        inv[7*i] = f[7*i];
        for (j = i + 1; j < 6; j++) {
            double sum = 0;
            for (k = i; k < j; k++) sum -= f[6*j + k]*inv[6*k + i];
            inv[6*j + i] = sum*f[7*j];
        }
    }
    for (i = 0; i < 6; i++)
        for (j = 0; j <= i; j++) {
            double sum = 0;
            for (k = i; k < 6; k++) sum += inv[6*k + i]*inv[6*k + j];
            m[6*i + j] = m[6*j + i] = sign*sum;
        }
}
/* c -= a b', 6 x 6 */
static void demi_block_less(double *c, const double *a, const double *b) {
    int i, j, k;
    for (i = 0; i < 6; i++)
        for (j = 0; j < 6; j++) {
            double sum = 0;
            for (k = 0; k < 6; k++) sum += a[6*i + k]*b[6*j + k];
            c[6*i + j] -= sum;
        }
}
/* y -= a x, or a' x */
static void demi_block_times(double *y, const double *a, const double *x, int transposed) {
    int i, k;
    for (i = 0; i < 6; i++)
        for (k = 0; k < 6; k++) y[i] -= a[transposed ? 6*k + i : 6*i + k]*x[k];
}
/* Returns the block of two linked nodes: column of the one eliminated first, rows of the other. */
static double *demi_nodes_block(const demi_solver *s, int a, int b) {
    const int early = s->nodes[a].rank < s->nodes[b].rank ? a : b, late = early == a ? b : a;
    int e = s->nodes[early].first;
    while (s->rows[e] != late) e++;
    return s->blocks + 36*((size_t)s->node_count + (size_t)e);
}
/* Assembles [M -J'; -J -give] and factors it: M of bodies, J rows of joints, give their softness.
   Rows that are not in force are -1 on the diagonal. */
static void demi_nodes_factor(dem_world *w) {
    demi_solver *s = &w->solver;
    double row[6];
    int i, k, e, l, rank;
    memset(s->blocks, 0, 36*((size_t)s->node_count + (size_t)s->row_count)*sizeof *s->blocks);
    for (i = 0; i < s->node_count; i++) {
        const demi_rod *r = s->rods + s->nodes[i].rod;
        if (s->nodes[i].rod < 0) demi_node_mass(w, s->nodes[i].mover, s->blocks + 36*(size_t)i);
        for (k = 0; k < 6 && s->nodes[i].rod >= 0; k++) {
            const int on = demi_rod_row(w, r, k);
            s->blocks[36*(size_t)i + 7*(size_t)k] = on ? -(double)r->give[k] : -1;
            for (e = 0; e < 2; e++) {
                const int body = r->ends[e];
                double *block;
                if (!on || body < 0) continue;
                block = demi_nodes_block(s, i, body);
                demi_rod_jacobian(w, r, e, k, row);
                for (l = 0; l < 6; l++)
                    block[s->nodes[body].rank < s->nodes[i].rank ? 6*k + l : 6*l + k] -= row[l];
            }
        }
    }
    for (rank = 0; rank < s->node_count; rank++) {
        const int v = s->nodes[rank].order, first = s->nodes[v].first;
        const int end = first + s->nodes[v].count;
        const double *columns = s->blocks + 36*(size_t)s->node_count;
        double *pivot = s->blocks + 36*(size_t)v;
        if (s->nodes[v].rod < 0) demi_block_invert(pivot, 1, 0);
        else demi_block_invert(pivot, -1, s->rods[s->nodes[v].rod].give);
        for (k = first; k < end; k++) {
            const int a = s->rows[k];
            double by[36];
            memset(by, 0, sizeof by);
            demi_block_less(by, columns + 36*(size_t)k, pivot);    /* - B D^-1 */
            for (l = 0; l < 36; l++) by[l] = -by[l];
            demi_block_less(s->blocks + 36*(size_t)a, by, columns + 36*(size_t)k);
            for (l = first; l < end; l++)
                if (s->nodes[s->rows[l]].rank < s->nodes[a].rank)
                    demi_block_less(demi_nodes_block(s, a, s->rows[l]), by, columns + 36*(size_t)l);
        }
    }
}
/* Solves the system: x of all nodes is the right-hand side before, and the solution after. */
static void demi_nodes_solve(demi_solver *s) {
    const double *columns = s->blocks + 36*(size_t)s->node_count;
    int rank, e;
    for (rank = 0; rank < s->node_count; rank++) {
        const demi_joint_node *k = s->nodes + s->nodes[rank].order;
        double y[6] = {0, 0, 0, 0, 0, 0};
        demi_block_times(y, s->blocks + 36*(k - s->nodes), k->x, 0);       /* - D^-1 x */
        for (e = 0; e < 6; e++) y[e] = -y[e];
        for (e = k->first; e < k->first + k->count; e++)
            demi_block_times(s->nodes[s->rows[e]].x, columns + 36*(size_t)e, y, 0);
    }
    while (rank-- > 0) {
        demi_joint_node *k = s->nodes + s->nodes[rank].order;
        double y[6] = {0, 0, 0, 0, 0, 0};
        for (e = k->first; e < k->first + k->count; e++)
            demi_block_times(k->x, columns + 36*(size_t)e, s->nodes[s->rows[e]].x, 1);
        demi_block_times(y, s->blocks + 36*(k - s->nodes), k->x, 0);
        for (e = 0; e < 6; e++) k->x[e] = -y[e];
    }
}
/* Sets up the rows of joint i: arms, axes, softness, and the impulses of the last step as the
   initial guess. */
static void demi_rod_lay(dem_world *w, int i) {
    demi_solver *s = &w->solver;
    demi_joint *j = &w->joints[i];
    demi_rod *r = s->rods + i;
    const demi_periods p = demi_periods_of(w);
    const demi_rod_end x = demi_rod_end_of(w, i, 0, 0), y = demi_rod_end_of(w, i, 1, 0);
    const dem_vec3 off = demi_nearest(&p, demi_sub(x.point, y.point));
    const int b = r->b < w->bodies.count;
    const demi_joint_node *group = s->nodes + (r->rows ? demi_node_group(s, r->node) : 0);
    const dem_real give = group->excess + !group->grounded > 0 ? DEMI_GIVE_LOOPS : DEMI_GIVE;
    int k, e;
    /* both arms end in the middle of the gap, which conserves angular momentum */
    r->arm[0] = demi_sub(x.arm, demi_scale(off, DEM_R(0.5)));
    r->arm[1] = b ? demi_add(y.arm, demi_scale(off, DEM_R(0.5))) : y.arm;
    j->state.gap = demi_length(off);
    j->state.tilt = demi_length(demi_cross(y.axis, x.axis));
    if (demi_joint_rows(j->desc.kind) > 3) {
        r->along[0] = demi_across(x.axis);
        r->along[1] = demi_cross(x.axis, r->along[0]);
        r->along[2] = x.axis;
        r->most = j->desc.motor == DEM_MOTOR_SPEED ? j->desc.torque*s->dt : 0;
        r->torque = j->desc.motor == DEM_MOTOR_TORQUE ? j->desc.torque*s->dt : 0;
    }
    demi_put(r->given, demi_scale(j->state.force, s->dt));
    for (k = 3; k < 5; k++) r->given[k] = demi_dot(j->state.torque, r->along[k - 3])*s->dt;
    r->given[5] = r->rows == 6 ? j->state.motor_torque*s->dt : 0;
    if (r->most > 0) {
        r->stuck = (r->given[5] >= r->most) - (r->given[5] <= -r->most);
        r->given[5] = DEMI_MAX(-r->most, DEMI_MIN(r->given[5], r->most));
    }
    for (k = 0; k < 6; k++) {
        dem_real sum = 0;
        for (e = 0; e < 2; e++) {
            const int body = e ? r->b : r->a;
            static const dem_vec3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
            const dem_vec3 l = k < 3 ? demi_cross(r->arm[e], unit[k]) : r->along[k - 3];
            if (r->ends[e] < 0) continue;
            sum += demi_dot(l, demi_mover_turn(s, body, l, w->bodies.shaped > 0));
            if (k < 3) sum += s->movers[body].inv;
        }
        r->give[k] = sum*(k < 5 ? give : give*DEM_R(1e-3));
        if (k >= r->rows) r->given[k] = 0;
    }
}
/* Returns the largest gap, m, that impulses may close: DEMI_EVEN of the way on which those of the
   last step move the bodies, or round-off. */
static double demi_rod_closed(const dem_world *w, const demi_rod *r) {
    const demi_solver *s = &w->solver;
    const dem_real pull = demi_length(demi_at(r->given))*
        (s->movers[r->a].inv + s->movers[r->b].inv);
    dem_real far = 0;
    int e;
    for (e = 0; e < 2; e++) {
        const int body = e ? r->b : r->a;
        far = DEMI_MAX(far, demi_length(r->arm[e]));
        if (body < w->bodies.count)
            far = DEMI_MAX(far, demi_length(demi_at(w->bodies.pos + 4*body)));
    }
    return DEMI_MAX(DEMI_EVEN*(double)(pull*s->dt),
                    (double)(8*(DEMI_SINGLE ? DEM_R(FLT_EPSILON) : DEM_R(DBL_EPSILON))*far));
}
/* Sets up all joints of this step: solver bodies of walls and space, rows, velocities before the
   step, and the energies and gaps of each group for the energy guard. A group with a gap begins at
   level 1: impulses that close a gap in a step would be far larger than those of the motion. */
static void demi_joints_lay(dem_world *w) {
    demi_solver *s = &w->solver;
    int i, e;
    for (i = 0; i < w->joint_count; i++) {
        demi_joint *j = &w->joints[i];
        demi_rod *r = s->rods + i;
        if (r->b >= w->bodies.count) {
            demi_mover *m = s->movers + r->b;
            memset(m, 0, sizeof *m);
            if (j->desc.wall.id) {
                const dem_pose *pose = &w->walls[demi_wall_place(j->desc.wall)].pose;
                demi_put(m->v, demi_surface_at(pose, demi_rod_end_of(w, i, 1, 0).point));
                demi_put(m->w, pose->spin);
            }
        }
        if (w->stage.forces_valid) j->state.work += (double)j->state.power*(double)s->dt;
        demi_rod_lay(w, i);
        for (e = 0; e < 2; e++) {               /* velocities before the step */
            const int body = e ? r->b : r->a;
            const dem_real sign = e ? -1 : 1;
            dem_vec3 v = demi_at(s->movers[r->b].v), turn = demi_at(s->movers[r->b].w);
            int k;
            if (body < w->bodies.count) {
                v = demi_at(w->bodies.vel + 4*body);
                turn = demi_at(w->bodies.spin + 4*body);
            }
            v = demi_add(v, demi_cross(turn, r->arm[e]));
            r->before[0] += sign*v.x; r->before[1] += sign*v.y; r->before[2] += sign*v.z;
            for (k = 3; k < 6; k++) r->before[k] += sign*demi_dot(turn, r->along[k - 3]);
        }
        if (w->stage.forces_valid) j->state.turned += (double)(s->dt*r->before[5]);
    }
    for (i = 0; i < s->node_count; i++) {
        const int body = s->nodes[i].mover;
        demi_joint_node *group = s->nodes + demi_node_group(s, i);
        if (body < 0) {
            demi_joint *j = w->joints + s->nodes[i].rod;
            const dem_real size = demi_rod_size(w, s->rods + s->nodes[i].rod), few = size/10;
            const dem_real gap = j->state.gap + j->state.tilt*size;
            group->bank += j->bank;
            group->wide = DEMI_MAX(group->wide, (double)gap);
            group->closed = DEMI_MAX(group->closed, demi_rod_closed(w, s->rods + s->nodes[i].rod));
            j->apart = gap > j->left + few ? gap : DEMI_MIN(j->apart, gap);
            group->open |= (j->apart > few)*2;
        } else group->kinetic += ((double)w->bodies.mass[body]*(double)demi_dot(
            demi_at(w->bodies.vel + 4*body), demi_at(w->bodies.vel + 4*body)) +
            (double)demi_dot(demi_angular_of(w, body), demi_at(w->bodies.spin + 4*body)))/2;
    }
    for (i = 0; i < s->node_count; i++) {
        s->nodes[i].guarded = s->nodes[i].wide > s->nodes[i].closed;
        s->nodes[i].open |= s->nodes[i].guarded;
    }
    s->factored = 0;
}
/* Warm start: applies the impulses of the last step, and those of motors with a given torque. */
static void demi_joints_warm(dem_world *w) {
    int i;
    for (i = 0; i < w->joint_count; i++) {
        const demi_rod *r = w->solver.rods + i;
        if (r->rows) demi_rod_apply(w, r, r->given, demi_add(demi_rod_twist(r, r->given),
                                                             demi_scale(r->along[2], r->torque)));
    }
}
/* Predicts the orientations of joined bodies at the next detection, by the integrator's scheme. */
static void demi_nodes_ahead(dem_world *w) {
    const demi_solver *s = &w->solver;
    int i;
    for (i = 0; i < s->node_count; i++) {
        const int body = s->nodes[i].mover;
        dem_quat q;
        dem_vec3 turn;
        dem_real dt;
        if (body < 0) continue;
        dt = demi_node_ahead(w, body);
        q = demi_quat_at(w->bodies.orient + 4*body);
        turn = demi_at(s->movers[body].w);
        if (w->bodies.shaped && w->bodies.shape[body]) {
            const dem_vec3 I = demi_at(w->bodies.moment + 4*body);
            const dem_vec3 inv = demi_v(1/I.x, 1/I.y, 1/I.z), m = dem_quat_unrotate(q, turn);
            const dem_vec3 L = dem_quat_rotate(q, demi_v(I.x*m.x, I.y*m.y, I.z*m.z));
            demi_rotation_rows[w->desc.rotation].fly(&q, L, I, inv, dt);
        } else q = demi_quat_again(dem_quat_multiply(demi_quat_exp(demi_scale(turn, dt)), q));
        s->nodes[i].turned = q;
    }
}
/* Returns the angular acceleration of a body that rotates with the spin without torque, rad/s2. */
static dem_vec3 demi_node_tumbles(const dem_world *w, int body, dem_vec3 spin) {
    const dem_quat q = demi_quat_at(w->bodies.orient + 4*body);
    const dem_vec3 I = demi_moments_of(w, body), x = dem_quat_unrotate(q, spin);
    const dem_vec3 L = dem_quat_rotate(q, demi_v(I.x*x.x, I.y*x.y, I.z*x.z));
    if (!demi_shape_of(w, body)) return demi_v(0, 0, 0);
    return demi_mover_turn(&w->solver, body, demi_cross(L, spin), 1);
}
/* Returns the acceleration of the point that a joint holds on a wall, m/s2. */
static dem_vec3 demi_rod_driven(const dem_world *w, int joint) {
    const demi_joint *j = &w->joints[joint];
    const demi_wall *wall = j->desc.wall.id ? &w->walls[demi_wall_place(j->desc.wall)] : 0;
    if (!wall || wall->motion.kind == DEM_MOTION_FIXED) return demi_v(0, 0, 0);
    return demi_scale(demi_sub(demi_held_speed(&wall->ahead, j->arm[1]),
                               demi_held_speed(&wall->was, j->arm[1])), 1/w->solver.dt);
}
/* Computes the acceleration of a relative to b in the first five rows if no force acted, m/s2 and
   rad/s2: the mean of those with the velocities before and after the step. */
static void demi_rod_bends(const dem_world *w, int joint, dem_real *bend) {
    const demi_rod *r = w->solver.rods + joint;
    const dem_vec3 x = r->along[2];
    dem_vec3 point = demi_v(0, 0, 0), axis = point;
    int e, after, k;
    for (after = 0; after < 2; after++) {
        dem_vec3 rate[2] = {{0, 0, 0}, {0, 0, 0}};
        for (e = 0; e < 2; e++) {
            const int body = e ? r->b : r->a;
            const dem_real half = e ? DEM_R(-0.5) : DEM_R(0.5);
            dem_vec3 spin = demi_at(w->solver.movers[body].w), tumbles = demi_v(0, 0, 0);
            if (body < w->bodies.count) {
                if (!after) spin = demi_at(w->bodies.spin + 4*body);
                tumbles = demi_node_tumbles(w, body, spin);
                point = demi_add(point, demi_scale(demi_add(demi_cross(tumbles, r->arm[e]),
                    demi_cross(spin, demi_cross(spin, r->arm[e]))), half));
            } else point = demi_add(point, demi_scale(demi_rod_driven(w, joint), half));
            rate[e] = demi_cross(spin, x);
            axis = demi_add(axis, demi_scale(demi_cross(x, demi_add(demi_cross(tumbles, x),
                                                        demi_cross(spin, rate[e]))), half));
        }
        axis = demi_add(axis, demi_cross(rate[1], rate[0]));
    }
    demi_put(bend, point);
    for (k = 3; k < 5; k++) bend[k] = demi_dot(axis, r->along[k - 3]);
}
/* Computes the residual velocities of a joint's rows, m/s and rad/s. Their target is that its
   points and axes coincide at the next detection. In a guarded group it is the relative velocity
   half a step after the one at which they would move along with each other (level 1), or the
   opposite of the velocity before the step (level 2), unless `shifts` is 1, which asks for the gaps
   to be closed by displacements. Returns the squared sum, (m/s)^2. */
static dem_real demi_rod_lacks(const dem_world *w, int i, int shifts, dem_real *lacks) {
    const demi_solver *s = &w->solver;
    const demi_rod *r = s->rods + i;
    const dem_real size = demi_rod_size(w, r);
    dem_real u[6], left = 0;
    int k;
    memset(lacks, 0, 6*sizeof *lacks);
    if (!r->rows) return 0;
    demi_rod_velocity(s, r, u);
    if (s->nodes[s->nodes[r->node].group].guarded && !shifts) {
        dem_real bend[6];
        if (s->nodes[s->nodes[r->node].group].guarded > 1)
            for (k = 0; k < 5; k++) lacks[k] = -r->before[k] - u[k];
        else {
            demi_rod_bends(w, i, bend);
            for (k = 0; k < 5; k++) lacks[k] = -bend[k]*s->dt/2 - u[k];
        }
    } else {
        const demi_periods p = demi_periods_of(w);
        const demi_rod_end x = demi_rod_end_of(w, i, 0, 1), y = demi_rod_end_of(w, i, 1, 1);
        const dem_vec3 off = demi_nearest(&p, demi_sub(x.point, y.point));
        const dem_vec3 tilt = demi_cross(y.axis, x.axis);       /* of a against b */
        const dem_real dt = DEMI_MAX(demi_node_ahead(w, r->a), demi_node_ahead(w, r->b));
        const dem_real part = DEMI_MIN(1, size/(10*demi_length(off) + DEMI_TINY))/dt;
        const dem_real turn = DEMI_MIN(1, DEM_R(0.1)/(demi_length(tilt) + DEMI_TINY))/dt;
        demi_put(lacks, demi_scale(off, -part));
        for (k = 0; k < 2; k++) lacks[3 + k] = -turn*demi_dot(tilt, r->along[k]);
    }
    if (!shifts) lacks[5] = (w->joints[i].desc.motor ? w->joints[i].desc.speed : 0) - u[5];
    for (k = 0; k < 6; k++) {
        if (!demi_rod_row(w, r, k)) lacks[k] = 0;
        else if (!shifts) lacks[k] -= r->give[k]*r->given[k];
        left += lacks[k]*lacks[k]*(k < 3 ? 1 : size*size);
    }
    return left;
}
/* Solves all joints simultaneously and, unless `shifts` is 1, applies the impulses. x of the nodes
   receives the changes of velocity and impulse. Returns the largest squared residual of a joint
   before the solve, (m/s)^2. */
static dem_real demi_joints_solve(dem_world *w, int shifts) {
    demi_solver *s = &w->solver;
    dem_real worst = 0, left, lacks[6];
    int i, k;
    if (!s->factored) demi_nodes_factor(w);
    s->factored = 1;
    demi_nodes_ahead(w);
    for (i = 0; i < s->node_count; i++) {
        demi_joint_node *node = s->nodes + i;
        memset(node->x, 0, sizeof node->x);
        if (node->rod < 0) continue;
        left = demi_rod_lacks(w, node->rod, shifts, lacks);
        worst = DEMI_MAX(worst, left);
        for (k = 0; k < 6; k++) node->x[k] = -(double)lacks[k];
    }
    demi_nodes_solve(s);
    for (i = 0; i < w->joint_count && !shifts; i++) {
        demi_rod *r = s->rods + i;
        dem_real by[6];
        if (!r->rows) continue;
        for (k = 0; k < 6; k++) r->given[k] += by[k] = (dem_real)s->nodes[r->node].x[k];
        demi_rod_apply(w, r, by, demi_rod_twist(r, by));
    }
    return worst;
}
/* Motors beyond their torque limit are set to the limit. With `free`, motors at the limit become
   rows again if their torque has the wrong sign. Returns how many motors changed. */
static int demi_motors_bound(dem_world *w, int free) {
    demi_solver *s = &w->solver;
    int i, n = 0;
    for (i = 0; i < w->joint_count; i++) {
        demi_rod *r = s->rods + i;
        dem_real by[6] = {0, 0, 0, 0, 0, 0}, u[6];
        if (r->rows < 6 || !(r->most > 0)) continue;
        if (r->stuck && free) {
            demi_rod_velocity(s, r, u);
            if (!((w->joints[i].desc.speed - u[5])*(dem_real)r->stuck < 0)) continue;
            r->stuck = 0;
            n++;
        } else if (!r->stuck && DEMI_ABS(r->given[5]) > r->most) {
            r->stuck = r->given[5] > 0 ? 1 : -1;
            by[5] = (dem_real)r->stuck*r->most - r->given[5];
            r->given[5] = (dem_real)r->stuck*r->most;
            demi_rod_apply(w, r, by, demi_rod_twist(r, by));
            n++;
        }
    }
    if (n) s->factored = 0;
    return n;
}
/* One sweep over the joints. Returns the largest squared residual before it, (m/s)^2, or 0 if this
   is below the round-off of positions. */
static dem_real demi_joints_sweep(dem_world *w) {
    const demi_solver *s = &w->solver;
    const dem_real enough = DEMI_JOINED*w->effects.radius_min/s->dt;
    dem_real worst, left, far2 = 0, digit;
    int rounds = 0, i;
    if (!s->node_count) return 0;
    for (i = 0; i < s->node_count; i++) {
        const dem_real *x = w->bodies.pos + 4*DEMI_MAX(s->nodes[i].mover, 0);
        far2 = DEMI_MAX(far2, demi_dot(demi_at(x), demi_at(x)));
    }
    digit = 8*(DEMI_SINGLE ? DEM_R(FLT_EPSILON) : DEM_R(DBL_EPSILON))/s->dt;
    demi_motors_bound(w, 1);
    worst = left = demi_joints_solve(w, 0);
    while (demi_motors_bound(w, 0) || (++rounds < 8 && left > enough*enough))
        left = demi_joints_solve(w, 0);
    return worst > digit*digit*far2 ? worst : 0;
}
/* Returns the work of a joint's impulses in the step, J, without its motor. It is exact with the
   mean of the velocities before and after. */
static double demi_rod_work(const dem_world *w, const demi_rod *r) {
    dem_real u[6];
    double work = 0;
    int k;
    demi_rod_velocity(&w->solver, r, u);
    for (k = 0; k < 5; k++)
        if (demi_rod_row(w, r, k)) work += (double)(r->given[k]*(r->before[k] + u[k]))/2;
    return work;
}
/* Energy guard: raises the level of each group whose joints would do more work than the energy that
   they have absorbed before. At level 1 they ask for the relative velocity that the points have
   half a step after they moved along with each other, -q dt/2, where q is their acceleration
   relative to each other without forces. Before the step it was q dt/2, so their work is only
   O(dt^4), and the forces are as smooth as q. Velocities that oscillate from step to step are
   forgotten. At level 2 joints reverse their velocities, which does no work whatever else acts.
   Returns the number of groups raised. */
static int demi_joints_guard(dem_world *w) {
    demi_solver *s = &w->solver;
    int i, n = 0;
    for (i = 0; i < s->node_count; i++) s->nodes[i].work = 0;
    for (i = 0; i < w->joint_count; i++) {
        const demi_rod *r = s->rods + i;
        if (r->rows) s->nodes[demi_node_group(s, r->node)].work += demi_rod_work(w, r);
    }
    for (i = 0; i < s->node_count; i++) {
        demi_joint_node *k = s->nodes + i;
        if (k->group != i || k->guarded > 1 || !(k->work > DEMI_MAX(k->bank, 0))) continue;
        k->guarded++;
        n++;
    }
    for (i = 0; i < s->node_count && n; i++) s->nodes[i].group = demi_node_group(s, i);
    return n;
}
/* Closes the gaps of guarded groups by displacements, as far as the energy that they may spend
   covers the work against gravity. Gaps that the user has made by moving a body are closed whatever
   the work. `digit` keeps round-off from deciding where the work is 0: displacements of a group
   that nothing holds leave its centre of mass. Returns the largest displacement, m. */
static double demi_joints_shift(dem_world *w) {
    const double digit = DEMI_SINGLE ? 1e-6 : 1e-12;
    demi_solver *s = &w->solver;
    double farthest = 0;
    int i, any = 0;
    for (i = 0; i < s->node_count; i++) any |= s->nodes[i].guarded && s->nodes[i].open;
    if (!any) return 0;
    demi_joints_solve(w, 1);
    for (i = 0; i < s->node_count; i++) s->nodes[i].work = 0;
    for (i = 0; i < s->node_count; i++) {
        const demi_joint_node *k = s->nodes + i;
        const demi_d3 g = demi_d3_of(w->desc.gravity), x = demi_d3_at(k->x);
        const double fall = demi_d3_dot(g, x) + digit*demi_d3_length(g)*demi_d3_length(x);
        if (k->mover >= 0) s->nodes[k->group].work -= fall*(double)(w->bodies.mass[k->mover]*s->dt);
    }
    for (i = 0; i < s->node_count; i++) {
        const demi_joint_node *k = s->nodes + i, *group = s->nodes + k->group;
        const double paid = group->open > 1 || !(group->work > group->spare) ? 1
            : group->spare/group->work;
        const dem_real by = (dem_real)paid*s->dt;
        const dem_vec3 way = demi_scale(demi_d3_real(demi_d3_at(k->x)), by);
        const dem_vec3 turn = demi_scale(demi_d3_real(demi_d3_at(k->x + 3)), by);
        dem_quat q;
        dem_real *o;
        if (!group->guarded || !group->open) continue;
        if (k->mover < 0) {
            if (group->work > 0 && group->bank > 0)
                w->joints[k->rod].bank *= 1 - DEMI_MIN(1, paid*group->work/group->bank);
            continue;
        }
        o = w->bodies.last_orient + 4*k->mover;  /* where demi_ahead_back puts it */
        q = demi_quat_again(dem_quat_multiply(demi_quat_exp(turn), demi_quat_at(o)));
        o[0] = q.w; o[1] = q.x; o[2] = q.y; o[3] = q.z;
        demi_force_add(w->bodies.last_pos + 4*k->mover, way);
        farthest = DEMI_MAX(farthest, (double)(demi_length(way) + demi_length(turn)*
                                               demi_radius(w, k->mover)));
    }
    return farthest;
}
/* Adds the energy that joints have absorbed in this step to what they may return later, at most
   DEMI_BANKED of the kinetic energy of their group. They need it because velocities that keep the
   points together oscillate about those that conserve energy. Displacements may spend what was
   there before this step, except for twice what that oscillation needs: half of p J u. */
static void demi_joints_bank(dem_world *w) {
    demi_solver *s = &w->solver;
    int i, k;
    for (i = 0; i < s->node_count; i++) {
        s->nodes[i].spare = s->nodes[i].bank;
        s->nodes[i].bank = s->nodes[i].work = 0;
    }
    for (i = 0; i < w->joint_count; i++) {
        const demi_rod *r = s->rods + i;
        demi_joint_node *group = s->nodes + (r->rows ? demi_node_group(s, r->node) : 0);
        dem_real u[6];
        w->joints[i].bank -= w->joints[i].held;
        if (!r->rows) continue;
        group->bank += w->joints[i].bank;
        demi_rod_velocity(s, r, u);
        for (k = 0; k < 5; k++) group->work += fabs((double)(r->given[k]*u[k]));
    }
    for (i = 0; i < w->joint_count; i++) {
        const demi_rod *r = s->rods + i;
        const demi_joint_node *group = r->rows ? s->nodes + demi_node_group(s, r->node) : 0;
        if (!group) w->joints[i].bank = 0;
        else if (group->bank > DEMI_BANKED*group->kinetic)
            w->joints[i].bank *= DEMI_BANKED*group->kinetic/group->bank;
    }
    for (i = 0; i < s->node_count; i++) {
        demi_joint_node *group = s->nodes + i;
        const double most = DEMI_BANKED*group->kinetic;
        group->bank = DEMI_MIN(group->bank, most);
        group->spare = DEMI_MAX(0, DEMI_MIN(group->spare, group->bank) -
                                DEMI_MIN(group->work, most/2));
    }
}
/* Returns the gap of joint i at the next detection, m, including the tilt times demi_rod_size. */
static dem_real demi_rod_gap(const dem_world *w, int i) {
    const demi_periods p = demi_periods_of(w);
    const demi_rod_end x = demi_rod_end_of(w, i, 0, 1), y = demi_rod_end_of(w, i, 1, 1);
    return demi_length(demi_nearest(&p, demi_sub(x.point, y.point))) +
        demi_length(demi_cross(y.axis, x.axis))*demi_rod_size(w, w->solver.rods + i);
}
/* Stores forces, torques, power and gaps of joints. Adds the forces to walls and fixed bodies. */
static void demi_joints_tell(dem_world *w) {
    const demi_solver *s = &w->solver;
    const dem_real per = 1/s->dt;
    int i, k;
    demi_nodes_ahead(w);
    for (i = 0; i < w->joint_count; i++) {
        const demi_rod *r = s->rods + i;
        demi_joint *j = &w->joints[i];
        dem_joint_state *o = &j->state;
        const int wall = j->desc.b.slot || !j->desc.wall.id ? -1
            : demi_wall_place(j->desc.wall);
        dem_real u[6];
        j->held = 0;
        j->left = 0;
        o->force = demi_scale(demi_at(r->given), per);
        o->motor_torque = r->rows ? (r->given[5] + r->torque)*per : 0;
        o->torque = demi_v(0, 0, 0);
        o->power = 0;
        if (!r->rows) continue;
        o->torque = demi_scale(demi_add(demi_rod_twist(r, r->given),
                                        demi_scale(r->along[2], r->torque)), per);
        demi_rod_velocity(s, r, u);
        j->left = demi_rod_gap(w, i);
        o->power = o->motor_torque*(r->before[5] + u[5])/2;
        j->held = demi_rod_work(w, r);
        for (k = 0; k < 2; k++) {
            const int body = k ? r->b : r->a;
            const dem_real sign = k ? -1 : 1;
            const dem_vec3 f = demi_scale(o->force, sign);
            const dem_vec3 t = demi_scale(demi_add(o->torque, demi_cross(r->arm[k], o->force)),
                                          sign);
            if (body >= w->bodies.count || r->ends[k] >= 0) continue;
            demi_force_add(w->bodies.force + 4*body, f);
            demi_force_add(w->bodies.torque + 4*body, t);
        }
        if (wall >= 0)
            demi_wall_sum_add(w, w->wall_sums + wall, wall, demi_rod_end_of(w, i, 1, 0).point,
                              o->force, o->torque, demi_at(s->movers[r->b].v));
    }
}
