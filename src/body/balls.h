/* ---------------------------------------------------------------------------------------------
   >>balls
   The spheres of which bodies consist: members of clusters, and lone spheres, each the only member
   of its body. They have two forms: as seen from the body's centre (bodies.centre), rotated with
   the body in each step; and, where forces need it (effects.clustered), as points in space
   (bodies.ball). This part owns both, and the inverse inertia of bodies in space (bodies.yield),
   which forces at points of bodies need.
   --------------------------------------------------------------------------------------------- */

/* A tile of bodies in their orientations, as a structure of arrays. */
typedef struct demi_frames {
    dem_real q[4][DEMI_ROOM], R[9][DEMI_ROOM];  /* quaternions; their matrices, by rows */
    dem_real I[3][DEMI_ROOM];                   /* kg m2, principal moments, 0 < I */
    dem_real free[DEMI_ROOM];                   /* 1; 0: fixed, or a sphere, whose W is 0 */
    dem_real W[6][DEMI_ROOM];                   /* inverse inertia in space, as bodies.yield */
} demi_frames;
/* Computes the rotation matrices of a tile from its quaternions. */
DEMI_CLONES static void demi_frames_turn(demi_frames *DEMI_RESTRICT f, int full) {
    DEMI_ROWS(full)
        const dem_real w = f->q[0][q], x = f->q[1][q], y = f->q[2][q], z = f->q[3][q];
        f->R[0][q] = 1 - 2*(y*y + z*z);
        f->R[1][q] = 2*(x*y - w*z);
        f->R[2][q] = 2*(x*z + w*y);
        f->R[3][q] = 2*(x*y + w*z);
        f->R[4][q] = 1 - 2*(x*x + z*z);
        f->R[5][q] = 2*(y*z - w*x);
        f->R[6][q] = 2*(x*z - w*y);
        f->R[7][q] = 2*(y*z + w*x);
        f->R[8][q] = 1 - 2*(x*x + y*y);
    DEMI_ROWS_END
}
/* Returns an element of R I^-1 R^T of body q. i, j: 3 times its row and its column. */
DEM_INLINE dem_real demi_frame_yield(const demi_frames *f, int i, int j, dem_vec3 inv, int q) {
    return f->R[i][q]*f->R[j][q]*inv.x + f->R[i + 1][q]*f->R[j + 1][q]*inv.y +
        f->R[i + 2][q]*f->R[j + 2][q]*inv.z;
}
/* Computes the inverse inertia in space of a tile, after demi_frames_turn. */
DEMI_CLONES static void demi_frames_yield(demi_frames *DEMI_RESTRICT f, int full) {
    DEMI_ROWS(full)
        const dem_vec3 inv = demi_v(f->free[q]/f->I[0][q], f->free[q]/f->I[1][q],
                                    f->free[q]/f->I[2][q]);
        f->W[0][q] = demi_frame_yield(f, 0, 0, inv, q);
        f->W[1][q] = demi_frame_yield(f, 3, 3, inv, q);
        f->W[2][q] = demi_frame_yield(f, 6, 6, inv, q);
        f->W[3][q] = demi_frame_yield(f, 0, 3, inv, q);
        f->W[4][q] = demi_frame_yield(f, 0, 6, inv, q);
        f->W[5][q] = demi_frame_yield(f, 3, 6, inv, q);
    DEMI_ROWS_END
}
/* Rotates member spheres to the present orientations of the listed bodies, once a step for all
   contacts. who: bodies, at most a tile; lone spheres and bodies without member spheres are
   skipped. */
static void demi_centres_rotate(const dem_world *w, const int *who, int listed) {
    int32_t body[DEMI_TILE];
    demi_frames f;
    int count = 0, l, k, e;
    for (l = 0; l < listed; l++)
        if (!demi_lone(w, who[l]) && demi_shape_of(w, who[l])->count) {
            for (e = 0; e < 4; e++) f.q[e][count] = w->bodies.orient[4*(size_t)who[l] + (size_t)e];
            body[count++] = who[l];
        }
    for (l = count; l % DEMI_LANES; l++)
        for (e = 0; e < 4; e++) f.q[e][l] = 0;
    demi_frames_turn(&f, l);
    for (l = 0; l < count; l++) {
        const demi_shape *shape = demi_shape_of(w, body[l]);
        const dem_real scale = demi_scale_of(w, body[l], shape), *part = shape->parts;
        dem_real *sphere = w->bodies.centre + 4*w->bodies.centre_start[body[l]], R[9];
        for (e = 0; e < 9; e++) R[e] = f.R[e][l]*scale;
        for (k = 0; k < shape->count; k++, sphere += 4, part += 4) {
            DEMI_UNROLL
            for (e = 0; e < 3; e++)
                sphere[e] = R[3*e]*part[0] + R[3*e + 1]*part[1] + R[3*e + 2]*part[2];
            sphere[3] = part[3]*scale;
        }
    }
}
/* Computes the spheres of all bodies in their present orientations. Returns 0 if memory ran out. */
static int demi_centres_lay(dem_world *w) {
    int32_t *start;
    int who[DEMI_TILE], count = 0, i, n = 0;
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
        !DEMI_GROW(w, w->bodies.yield, 6*(size_t)w->bodies.count + 1) ||
        (w->effects.clustered && !DEMI_GROW(w, w->bodies.ball, 4*((size_t)n + 1)))) return 0;
    memset(w->bodies.yield, 0, 6*(size_t)w->bodies.count*sizeof(dem_real));
    w->bodies.centres_valid = 1;
    for (i = 0; i < w->bodies.count; i++) {
        dem_real *lone = w->bodies.centre + 4*start[i];
        if (!demi_lone(w, i)) who[count++] = i;
        else {
            lone[0] = lone[1] = lone[2] = 0;
            lone[3] = demi_radius(w, i);
        }
        if (count == DEMI_TILE || i + 1 == w->bodies.count) {
            demi_centres_rotate(w, who, count);
            count = 0;
        }
    }
    return 1;
}
/* Computes the inverse inertia in space (bodies.yield) of bodies begin .. end - 1, at most a
   tile. That of spheres is 0 from demi_centres_lay on. */
static void demi_yields_turn(const dem_world *w, int begin, int end) {
    const int count = end - begin, full = (count + DEMI_LANES - 1)/DEMI_LANES*DEMI_LANES;
    demi_frames f;
    int l, e, shaped = 0;
    for (l = begin; l < end; l++) shaped |= demi_shape_of(w, l) != 0;
    if (!shaped) return;
    for (l = 0; l < full; l++) {
        const int i = begin + DEMI_MIN(l, count - 1);
        const int turns = demi_shape_of(w, i) && w->bodies.inv_mass[i] > 0;
        f.free[l] = turns ? DEM_R(1) : DEM_R(0);
        for (e = 0; e < 4; e++) f.q[e][l] = turns ? w->bodies.orient[4*i + e] : 0;
        for (e = 0; e < 3; e++) f.I[e][l] = turns ? w->bodies.moment[4*i + e] : 1;
    }
    demi_frames_turn(&f, full);
    demi_frames_yield(&f, full);
    for (l = 0; l < count; l++)
        for (e = 0; e < 6; e++) w->bodies.yield[6*(begin + l) + e] = f.W[e][l];
}
/* Sets what contacts need of bodies begin .. end - 1 in their present orientations: bodies.yield
   and, with effects.clustered, the spheres in space. */
static void demi_balls_place(const dem_world *w, int begin, int end) {
    int i, k, e;
    for (i = begin; i < end; i++) {
        const dem_real *x = w->bodies.pos + 4*i;
        const int first = w->bodies.centre_start[i], last = w->bodies.centre_start[i + 1];
        if ((i - begin) % DEMI_TILE == 0) demi_yields_turn(w, i, DEMI_MIN(i + DEMI_TILE, end));
        for (k = first; k < last && w->effects.clustered; k++) {
            const dem_real *arm = w->bodies.centre + 4*k;
            dem_real *ball = w->bodies.ball + 4*k;
            DEMI_UNROLL
            for (e = 0; e < 3; e++) ball[e] = x[e] + arm[e];
            ball[3] = arm[3];
        }
    }
}
