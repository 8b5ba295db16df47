/* ---------------------------------------------------------------------------------------------
   >>balls
   The spheres of which bodies consist: members of clusters, and lone spheres, each the only member
   of its body. They have two forms: as seen from the body's centre (bodies.centre), rotated with
   the body in each step; and, where forces need it (effects.clustered), as points in space with a
   velocity and an effective mass (bodies.ball). This part owns both.
   --------------------------------------------------------------------------------------------- */
/* Computes the spheres of all bodies in their present orientations. Returns 0 if memory ran out. */
static int demi_centres_lay(dem_world *w) {
    int32_t *start;
    int i, n = 0;
    if (!DEMI_GROW(w, w->bodies.centre_start, (size_t)w->bodies.count + 1)) return 0;
    start = w->bodies.centre_start;
    for (i = 0; i < w->bodies.count; i++) {
        const demi_shape *shape = demi_shape_of(w, i);
        start[i] = n;
        if (shape && n > INT_MAX/8 - shape->count) return 0;
        n += shape ? shape->count : 1;
    }
    start[i] = n;
    if (!DEMI_GROW(w, w->bodies.centre, 4*((size_t)n + 1)) ||
        (w->effects.clustered && (!DEMI_GROW(w, w->bodies.ball, 4*((size_t)n + 1)) ||
                                  !DEMI_GROW(w, w->bodies.yield, 6*(size_t)w->bodies.count + 1))))
        return 0;
    w->bodies.centres_valid = 1;
    for (i = 0; i < w->bodies.count; i++) {
        dem_real *lone = w->bodies.centre + 4*start[i];
        if (demi_shape_of(w, i)) {
            if (demi_shape_of(w, i)->count) demi_centres_rotate(w, i);
        } else {
            lone[0] = lone[1] = lone[2] = 0;
            lone[3] = w->bodies.pos[4*i + 3];
        }
    }
    return 1;
}
/* Sets W to the inverse inertia of a body in space, see bodies.yield. */
static void demi_body_yield(const dem_world *w, int body, dem_real *W) {
    const dem_real *I = w->bodies.moment + 4*body;
    double R[9], a, b, c;
    int k;
    for (k = 0; k < 6; k++) W[k] = 0;
    if (!demi_shape_of(w, body) || !(w->bodies.inv_mass[body] > 0)) return;
    a = 1/(double)I[0]; b = 1/(double)I[1]; c = 1/(double)I[2];
    demi_rotation_of(demi_quat_at(w->bodies.orient + 4*body), R);
    for (k = 0; k < 3; k++)
        W[k] = (dem_real)(R[3*k]*R[3*k]*a + R[3*k + 1]*R[3*k + 1]*b + R[3*k + 2]*R[3*k + 2]*c);
    W[3] = (dem_real)(R[0]*R[3]*a + R[1]*R[4]*b + R[2]*R[5]*c);
    W[4] = (dem_real)(R[0]*R[6]*a + R[1]*R[7]*b + R[2]*R[8]*c);
    W[5] = (dem_real)(R[3]*R[6]*a + R[4]*R[7]*b + R[5]*R[8]*c);
}
/* Sets the spheres of bodies begin .. end - 1 in space, and what their contacts need of the bodies
   (bodies.ball, bodies.yield). */
static void demi_balls_place(const dem_world *w, int begin, int end) {
    int i, k, e;
    for (i = begin; i < end; i++) {
        const dem_real *x = w->bodies.pos + 4*i;
        const int first = w->bodies.centre_start[i], last = w->bodies.centre_start[i + 1];
        demi_body_yield(w, i, w->bodies.yield + 6*i);
        for (k = first; k < last; k++) {
            const dem_real *arm = w->bodies.centre + 4*k;
            dem_real *ball = w->bodies.ball + 4*k;
            DEMI_UNROLL
            for (e = 0; e < 3; e++) ball[e] = x[e] + arm[e];
            ball[3] = arm[3];
        }
    }
}
