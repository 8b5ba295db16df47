/* ---------------------------------------------------------------------------------------------
   >>servo
   Servo walls (DEM_MOTION_SERVO): before each step the speed of the wall is chosen from the force
   that grains exert on it, so that the force approaches a target. The wall has no inertia. Owns
   `servo` of walls; reads their loads and the persistent contacts of the last step. In a team the
   sums extend over all members, in their order, and the walls of the first member move.

   The law. Let K and C be the sums of normal stiffness and damping over the contacts of the wall, F
   the present force, T the target, v and u the speeds towards the grains in the coming and in the
   last step:
       K dt (v - b u) + C (v - u) = a (T - F),   |v| at most the largest speed,
   a = DEMI_SERVO_GAIN, b = DEMI_SERVO_KEPT. With C = b = 0 this is the servo of the triaxial cell
   of YADE, which moves by (1 - damping)(T - F)/K in a step (TriaxialStressController: K is summed
   over the contacts of the wall), and that of PFC, v = a (T - F)/(k N dt) for N contacts of
   stiffness k. The terms of C make up for the change of the damping force, C (v - u): without them
   the servo is unstable from step to step if C > K dt/a. The term of b makes it a PI controller.
   While the target changes at a rate R, the error is R K dt (1 - b)/(a B) on a bed of stiffness B.
   Stability. While grains rest, the error of contacts without damping obeys z^2 - (1 + b - a) z + b
   = 0, whose roots are inside the unit circle if a < 2 + 2 b [Jury]: contacts may be 7 times as
   stiff as K says, and four times as damped as C says. If grains move, the wall acts on them as a
   dashpot K dt (1 - b)/a and a mass (b K dt + C) dt/a, which never supply energy. The mass is of
   the order dt/t_c of that of the grains in contact.
   --------------------------------------------------------------------------------------------- */
#define DEMI_SERVO_GAIN 0.5        /* a; below its limit, since K grows with new contacts */
#define DEMI_SERVO_KEPT 0.9        /* b */

/* Returns the force along the direction of wall `of` that wall i exerts on the grains of w, N; 0 if
   it is not part of the same piston. first: the world whose walls move. */
static double demi_servo_force_of(const dem_world *first, const dem_world *w, int of, int i) {
    const demi_wall *walls = first->walls;
    if (walls[i].kind == DEMI_WALL_NONE || !demi_walls_alike(&walls[i], &walls[of])) return 0;
    return -(double)demi_dot(w->walls[i].loads.force, demi_unit(walls[of].motion.velocity));
}
/* Returns the sum over the piston. */
static double demi_servo_force(const dem_world *first, const dem_world *w, int of) {
    double sum = 0;
    int i;
    for (i = 0; i < w->wall_count; i++) sum += demi_servo_force_of(first, w, of, i);
    return sum;
}
/* Books the work that follows from a change of the wall's speed, m/s. The step has booked F v dt
   with the speed before, but half of the impulse F dt acts after the change. */
static void demi_servo_book(dem_world *w, const dem_world *first, int of, double change) {
    int i;
    for (i = 0; i < w->wall_count; i++) {
        const double work = demi_servo_force_of(first, w, of, i)*change*(double)w->clock.dt/2;
        w->walls[i].loads.work += work;
        if (w->desc.ledger) w->booked.energy[DEMI_E_WALLS] += work;
    }
}
/* `part` of `sum` in demi_team: that force, and the sums of stiffness and damping over the contacts
   of the group, as the built-in laws have them or by desc.law_stiffness. A body that is not a
   sphere counts with its whole mass, so its damping is an upper bound. */
enum { DEMI_SERVO_FORCE, DEMI_SERVO_STIFFNESS, DEMI_SERVO_DAMPING, DEMI_SERVO_SUMS };
static void demi_servo_part(const dem_world *w, int of, double *out) {
    const dem_world *first = w->team ? w->team->members[0] : w;
    const demi_wall *walls = first->walls;
    int d;
    out[DEMI_SERVO_FORCE] = demi_servo_force(first, w, of);
    out[DEMI_SERVO_STIFFNESS] = out[DEMI_SERVO_DAMPING] = 0;
    for (d = 0; d < w->domain_count; d++) {
        const demi_persistent *c = demi_persistent_of(w, d), *end = c + w->domains[d].persistent;
        for (; c < end && w->domains[d].walls; c++) {
            const double slope = (double)c->slope;
            dem_real coef[DEMI_COEFS], root[2];
            demi_stiffness s;
            /* a body that has changed slab has left its contacts there until forces are computed */
            if (c->b >= 0 || demi_is_ghost(w, c->a) ||
                !demi_walls_alike(&walls[c->wall], &walls[of]) ||
                (!(c->overlap > 0) && !(w->margin.reach > 0))) continue;
            demi_persistent_coefs(w, c, coef, root);
            coef[DEMI_CN] += root[0]*DEMI_SQRT(w->bodies.mass[c->a]);
            s = demi_stiffness_normal(w, coef, (double)DEMI_MAX(c->overlap, 0));
            if (demi_normal_is(w, DEMI_BRANCHED)) s.k = (double)coef[DEMI_K_UN];
            if (w->desc.law && w->desc.law_stiffness > 0) s.k = (double)w->desc.law_stiffness;
            out[DEMI_SERVO_STIFFNESS] += s.k*slope*slope*(double)c->lift;
            out[DEMI_SERVO_DAMPING] += s.c*slope*(double)c->share;
        }
    }
}
/* Sums over all members, see `sum` of demi_team. */
static dem_result demi_servo_sum(dem_world *h, int of, double *sums) {
    if (h->team) return h->team->sum(h, demi_servo_part, of, sums, DEMI_SERVO_SUMS);
    demi_servo_part(h, of, sums);
    return DEM_OK;
}
/* Chooses the speed of wall w for the step that begins now. */
static void demi_servo_choose(const dem_world *h, demi_wall *wall, const double *sums) {
    const dem_motion *m = &wall->motion;
    const double dt = (double)h->clock.dt, most = (double)demi_length(m->velocity);
    const double far = m->travel > 0 ? (double)m->travel : DEMI_FARTHEST;
    dem_servo *s = &wall->servo;
    double push, gives;
    s->travel += s->speed*(h->clock.time - s->time);
    s->time = h->clock.time;
    s->target = demi_servo_target(m, s->time);
    s->force = sums[DEMI_SERVO_FORCE];
    s->stiffness = sums[DEMI_SERVO_STIFFNESS];
    s->damping = sums[DEMI_SERVO_DAMPING];
    push = DEMI_SERVO_GAIN*(s->target - s->force) +
        (DEMI_SERVO_KEPT*s->stiffness*dt + s->damping)*s->speed;
    gives = s->stiffness*dt + s->damping;
    s->speed = fabs(push) < most*gives ? push/gives : push > 0 ? most : push < 0 ? -most : 0;
    if (fabs(s->travel + s->speed*dt) > far)
        s->speed = ((s->speed > 0 ? far : -far) - s->travel)/dt;
}
/* Returns the first wall of the piston of wall i. */
static int demi_servo_leader(const dem_world *first, int i) {
    int k = 0;
    while (k < i && (first->walls[k].kind == DEMI_WALL_NONE ||
                     !demi_walls_alike(&first->walls[k], &first->walls[i]))) k++;
    return k;
}
/* Chooses the speeds of all servo walls; the first wall of a piston decides for the others. */
static dem_result demi_servos_lead(dem_world *h) {
    dem_world *first = demi_member(h, 0);
    double sums[DEMI_SERVO_SUMS], before;
    dem_result result = DEM_OK;
    int i, k;
    for (i = 0; i < first->wall_count && result == DEM_OK; i++) {
        demi_wall *wall = &first->walls[i];
        if (wall->kind == DEMI_WALL_NONE || wall->motion.kind != DEM_MOTION_SERVO ||
            h->clock.time < wall->motion.start) continue;
        k = demi_servo_leader(first, i);
        if (k != i) { wall->servo = first->walls[k].servo; continue; }
        result = demi_servo_sum(h, i, sums);
        if (result != DEM_OK) break;
        before = wall->servo.speed;
        demi_servo_choose(h, wall, sums);
        for (k = 0; k < demi_members(h); k++)
            demi_servo_book(demi_member(h, k), first, i, wall->servo.speed - before);
    }
    return result;
}
/* Returns the state of a servo wall at the present time. */
static dem_servo demi_servo_now(const dem_world *w, int wall) {
    const dem_motion *m = &w->walls[wall].motion;
    dem_servo s = w->walls[wall].servo;
    s.travel += w->clock.time > s.time ? s.speed*(w->clock.time - s.time) : 0;
    s.target = w->clock.time < m->start ? 0 : demi_servo_target(m, w->clock.time);
    s.force = demi_servo_force(w, w, wall);
    return s;
}
DEM_API dem_result dem_wall_servo_get(const dem_world *world, dem_wall id, dem_servo *servo) {
    int i;
    if (demi_null_look(world, __func__, servo, "servo")) return DEM_ERROR_ARGUMENT;
    i = demi_wall_find((dem_world *)world, __func__, id);
    if (i < 0) return DEM_ERROR_ARGUMENT;
    if (world->walls[i].motion.kind != DEM_MOTION_SERVO)
        return demi_refuse(world, __func__, "the motion of wall %d is not "
                           "DEM_MOTION_SERVO; set it with dem_wall_motion_set", (int)id.id);
    *servo = demi_servo_now(world, i);
    return DEM_OK;
}
