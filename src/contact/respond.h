/* ---------------------------------------------------------------------------------------------
   >>respond
   Stages that compute contact forces between spheres for a tile of candidate pairs at a time. First
   the data of both bodies are copied into rows, pair after pair (a copy of three adjacent numbers
   is cheaper than three gathers). Then stages run over the rows, one after the other: contact
   detection, relative motion, normal law, friction, rolling, force and torques. They work on vector
   groups of constant length, which compilers vectorise at -O2 too. The most common combinations of
   laws have one stage for all laws, which avoids the rows in between. >>choose chooses the stages.
   --------------------------------------------------------------------------------------------- */
/* Sums and differences are of the two bodies of a pair: a + b and a - b. */
/* Rows that are filled one by one. gcc gets x and y side by side, which one instruction moves
   (saves 5 % of a step in single precision, 2 % in double); clang vectorises that layout badly. */
#if defined(__GNUC__) && !defined(__clang__)
typedef struct demi_rows { dem_real xy[DEMI_ROOM][2], z[DEMI_ROOM]; } demi_rows;
#define DEMI_XY(rows, e, q) (rows)->xy[q][e]
#else
typedef struct demi_rows { dem_real xy[2][DEMI_ROOM], z[DEMI_ROOM]; } demi_rows;
#define DEMI_XY(rows, e, q) (rows)->xy[e][q]
#endif
typedef struct demi_tile {
    /* filled from the bodies */
    demi_rows gap;                 /* m, from a to b */
    demi_rows rate, gone;          /* m/s, relative velocity: now; over the last step */
    demi_rows late;                /* m/s, difference of prediction errors: ledger */
    demi_rows around, turned;      /* rad/s, sum of spins: likewise */
    demi_rows apart, parted;       /* rad/s, difference of spins: likewise */
    dem_real radius[2][DEMI_ROOM];
    dem_real memory[DEMI_MEMORY + 1][DEMI_ROOM];           /* last: if `sliding` is not kept */
    dem_real coef[DEMI_TILE_COLUMNS][DEMI_ROOM];
    /* contact detection and relative motion */
    dem_real length[DEMI_ROOM], over_d[DEMI_ROOM], overlap[DEMI_ROOM], deep[DEMI_ROOM];
    dem_real touch[DEMI_ROOM];      /* 1: in contact, or within a law's range; else 0 */
    dem_real normal[3][DEMI_ROOM], turn[3][DEMI_ROOM];      /* unit, 1/s */
    dem_real slip[3][DEMI_ROOM], slip_step[3][DEMI_ROOM];   /* m/s */
    dem_real lean[DEMI_ROOM];       /* m, from midway between the centres to the contact, to b */
    dem_real closing[DEMI_ROOM], twist[DEMI_ROOM];
    /* what each law passes to the next (see dem_contact_force), also for pairs without contact */
    dem_real repulsion[DEMI_ROOM], load[DEMI_ROOM], slope[2][DEMI_ROOM], kt[2][DEMI_ROOM];
    dem_real ct[DEMI_ROOM], tangent[3][DEMI_ROOM], moment[3][DEMI_ROOM];
    dem_real part[7][DEMI_ROOM];                           /* energies */
    /* force and torques */
    dem_real force[3][DEMI_ROOM], torque[2][3][DEMI_ROOM];  /* torque: on a, on b */
    /* these are last, so that rows begin on cache lines (3 % of a step) */
    int row;                       /* the row of species_coef in all of coef; -1: none */
    dem_real gains[DEMI_ROOM][2*DEM_BODY_REALS];   /* 1/s, of user-defined numbers */
} demi_tile;
/* Up to a tile of contacts: consecutive entries of the pruned list, or those of >>points. */
typedef struct demi_span {
    const int32_t *a, *b;          /* bodies; of >>points: b < 0 is wall -1 - b */
    const int32_t *k;              /* candidate: slot for a b of a later work group; of >>points: or
                                      -1 */
    const unsigned char *image;
    dem_real *memory;              /* column e of pair q: memory[e*stride + q] */
    const int32_t *row;            /* of the table of species, or null */
    const dem_real *coef;          /* columns likewise; row and coef are null if all are alike */
    struct demi_points *points;    /* the tile of >>points; null: lone spheres */
    size_t stride;
    int count;
} demi_span;
/* Returns the span of `count` pairs of work group d from entry p on. */
static demi_span demi_span_of(const dem_world *w, int d, int p, int count) {
    const demi_near *near = &w->near;
    const size_t stride = (size_t)near->stride, at = (size_t)d*stride + (size_t)p;
    demi_span s;
    s.a = near->a + at;
    s.b = near->b + at;
    s.k = near->k + at;
    s.image = near->image + at;
    s.memory = near->memory ? near->memory + (size_t)d*(size_t)w->memory_stride*stride + p : 0;
    s.row = w->effects.uniform || demi_many_species(w) ? 0 : near->row + at;
    s.coef = demi_many_species(w) ? near->coef + (size_t)d*DEMI_PAIR_COLUMNS*stride + p : 0;
    s.points = 0;
    s.stride = stride;
    s.count = count;
    return s;
}

/* Copies the coefficients of pair q that stages read. */
static void demi_span_coefs(const dem_world *w, const demi_span *s, int q, dem_real *coef) {
    const int row = s->row ? s->row[q] : 0;
    int e;
    for (e = 0; e < DEMI_TILE_COLUMNS; e++)
        coef[e] = s->coef ? s->coef[(size_t)e*s->stride + (size_t)q]
            : w->species_coef[DEMI_PAIR_COLUMNS*row + e];
}

DEM_INLINE dem_vec3 demi_row(dem_real rows[3][DEMI_ROOM], int q) {
    return demi_v(rows[0][q], rows[1][q], rows[2][q]);
}
DEM_INLINE void demi_row_put(dem_real rows[3][DEMI_ROOM], int q, dem_vec3 v) {
    rows[0][q] = v.x; rows[1][q] = v.y; rows[2][q] = v.z;
}
/* count: a multiple of DEMI_LANES */
static void demi_row_copy(dem_real *DEMI_RESTRICT to, const dem_real *DEMI_RESTRICT from,
                          int count) {
    int q, l;
    for (q = 0; q < count; q += DEMI_LANES)
        for (l = 0; l < DEMI_LANES; l++) to[q + l] = from[q + l];
}
/* Fill row q from the bodies: a - b, a + b, a - b + shift. */
DEM_INLINE void demi_rows_minus(demi_rows *DEMI_RESTRICT rows, size_t q, const dem_real *a,
                                const dem_real *b) {
    const dem_real x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    DEMI_XY(rows, 0, q) = x;
    DEMI_XY(rows, 1, q) = y;
    rows->z[q] = z;
}
DEM_INLINE void demi_rows_plus(demi_rows *DEMI_RESTRICT rows, size_t q, const dem_real *a,
                               const dem_real *b) {
    const dem_real x = a[0] + b[0], y = a[1] + b[1], z = a[2] + b[2];
    DEMI_XY(rows, 0, q) = x;
    DEMI_XY(rows, 1, q) = y;
    rows->z[q] = z;
}
DEM_INLINE void demi_rows_shifted(demi_rows *DEMI_RESTRICT rows, size_t q, const dem_real *a,
                                  const dem_real *b, const dem_real *shift) {
    const dem_real x = a[0] - b[0] + shift[0], y = a[1] - b[1] + shift[1];
    const dem_real z = a[2] - b[2] + shift[2];
    DEMI_XY(rows, 0, q) = x;
    DEMI_XY(rows, 1, q) = y;
    rows->z[q] = z;
}
DEM_INLINE void demi_rows_put(demi_rows *DEMI_RESTRICT rows, int q, dem_vec3 v) {
    DEMI_XY(rows, 0, q) = v.x;
    DEMI_XY(rows, 1, q) = v.y;
    rows->z[q] = v.z;
}
DEM_INLINE dem_vec3 demi_rows_at(const demi_rows *rows, int q) {
    return demi_v(DEMI_XY(rows, 0, q), DEMI_XY(rows, 1, q), rows->z[q]);
}

/* Laws use predicted velocities, but the ledger needs those of the actual path (demi_late_note).
   Returns the relative excess of the actual closing speed over the predicted one. It uses the error
   of the last prediction, since the forces of this step are not known yet. */
DEM_INLINE dem_real demi_late_share(dem_vec3 late, dem_vec3 normal, dem_real closing) {
    return demi_dot(late, normal)/(closing > 0 || closing < 0 ? closing : 1);
}

/* Constants of a run. A stage takes a copy, so that compilers see that nothing changes them. */
typedef struct demi_same {
    dem_real dt, radius, inv_radius;
    dem_real range, range_radii;   /* m; factor: the range of a law, or 0 */
    int tension, friction_load, slider;
    int rolls, at_rolling, at_normal;          /* is there a rolling law? where history begins */
    int at_sliding, at_twisting;   /* rows of memory that hold `sliding`, the twisting moment */
} demi_same;
/* What a scene needs: a run is a list of stages with their settings. */
typedef struct demi_run demi_run;
typedef void (*demi_stage)(demi_tile *DEMI_RESTRICT t, const demi_run *r, int full);
enum { DEMI_STAGES = 7 };
struct demi_run {
    const dem_world *w;
    const demi_span *span;         /* the contacts */
    int alike, ledger, keep;       /* are both bodies alike? keep: reals of history */
    int usual;                     /* demi_laws_usual */
    int turning, parting;          /* are spins, differences of spins needed? */
    int following;                 /* is the motion over the last step needed? */
    int ranged;                    /* does the law have a range? */
    demi_same same;
    demi_stage stage[DEMI_STAGES]; /* in this order, up to the first null */
};
/* A tile of contacts at points of bodies (>>points): of member spheres, or persistent ones. It adds
   to the rows above what lone spheres do not need. */
typedef struct demi_points {
    demi_rows arm[2], mid[2];      /* m, from both centres to the contact: now; at mid-step */
    demi_rows spin[2], spun[2];    /* rad/s, of a and b: now; over the last step */
    demi_rows outset;              /* m: see demi_persistent_more */
    dem_real couple[DEMI_ROOM];    /* m: likewise */
    dem_real share[DEMI_ROOM], grip[DEMI_ROOM];            /* weights: of damping, of friction */
    dem_real lift[DEMI_ROOM];      /* weight of the elastic force, minus share */
    dem_real still[DEMI_ROOM];     /* N, elastic force of those that are lifted */
    dem_real slope[DEMI_ROOM];     /* change of the overlap per distance */
    dem_real base[DEMI_COEFS][DEMI_ROOM], root[2][DEMI_ROOM];      /* coefficients without slope */
    dem_real known[DEMI_ROOM];     /* kg, m*; 0: depends on the following */
    demi_rows felt[2];             /* m, arms for effective masses */
    dem_real inv[DEMI_ROOM], yield[2][6][DEMI_ROOM];       /* 1/kg, of both; as in demi_bodies */
    demi_tile rows;
    /* the remaining fields are last, so that all rows begin on cache lines */
    int32_t a[DEMI_TILE], b[DEMI_TILE], k[DEMI_TILE];      /* see demi_span */
    demi_persistent *contact[DEMI_TILE]; /* null: of two member spheres */
    dem_real *home[DEMI_TILE];     /* where the history goes: real e to home[e*hop] */
    dem_vec3 at[DEMI_TILE], surface[DEMI_TILE];    /* m, point on a wall; m/s, its velocity */
    dem_vec3 aside[DEMI_TILE],
        side[2][DEMI_TILE]; /* see demi_persistent_more; m, arms of a and b where
                                                      it acts */
    unsigned char raised[DEMI_TILE];               /* 1: lifted; 2: likewise, with `aside` */
    const demi_coefs_row *filled[DEMI_TILE];       /* what base and root contain; null: unknown */
    demi_span span;
    demi_run run, laws;            /* all stages; those of the laws only */
    size_t hop;
    int count, ready;              /* contacts; rows that have ever been filled */
    int turns, weighted, lifted;   /* is any m* unknown? any weight not 1? any lifted? */
} demi_points;

/* Copies the data of bodies that the stages need into the rows. */
DEM_INLINE void demi_fetch(const demi_run *r, int count, demi_tile *DEMI_RESTRICT t, int uniform,
                           int turning, int parting, int following) {
    const dem_world *w = r->w;
    const dem_real *DEMI_RESTRICT x = w->bodies.pos, *DEMI_RESTRICT shift = w->image_shift;
    const dem_real *DEMI_RESTRICT u = w->bodies.vel, *DEMI_RESTRICT s = w->bodies.spin;
    const dem_real *DEMI_RESTRICT uh = w->bodies.half_vel, *DEMI_RESTRICT sh = w->bodies.half_spin;
    const int32_t *DEMI_RESTRICT la = r->span->a, *DEMI_RESTRICT lb = r->span->b;
    const unsigned char *DEMI_RESTRICT image = r->span->image;
    int n;
    for (n = 0; n < count; n++) {
        size_t q = (size_t)n;
        const dem_real *a, *b, *c;
        uint32_t i, j;
        DEMI_ONE_BY_ONE(q);
        i = (uint32_t)la[q]; j = (uint32_t)lb[q];
        if (n + DEMI_TILE/2 < count) {          /* neighbours may be far apart in memory */
            const uint32_t next = (uint32_t)lb[q + DEMI_TILE/2];
            DEMI_FETCH(DEMI_AT(u, next));
            if (turning) DEMI_FETCH(DEMI_AT(s, next));
            if (following) { DEMI_FETCH(DEMI_AT(uh, next)); DEMI_FETCH(DEMI_AT(sh, next)); }
        }
        a = DEMI_AT(x, i); b = DEMI_AT(x, j); c = shift + image[q];
        demi_rows_shifted(&t->gap, q, b, a, c);
        if (!uniform) { t->radius[0][q] = a[3]; t->radius[1][q] = b[3]; }
        demi_rows_minus(&t->rate, q, DEMI_AT(u, i), DEMI_AT(u, j));
        if (turning) demi_rows_plus(&t->around, q, DEMI_AT(s, i), DEMI_AT(s, j));
        if (parting) demi_rows_minus(&t->apart, q, DEMI_AT(s, i), DEMI_AT(s, j));
        if (!following) continue;
        demi_rows_minus(&t->gone, q, DEMI_AT(uh, i), DEMI_AT(uh, j));
        demi_rows_plus(&t->turned, q, DEMI_AT(sh, i), DEMI_AT(sh, j));
        if (parting) demi_rows_minus(&t->parted, q, DEMI_AT(sh, i), DEMI_AT(sh, j));
    }
}
/* Calls a copy of demi_fetch that is compiled for the needs of the scene, without branches
   inside. */
static void demi_tile_fetch(const demi_run *r, int count, demi_tile *DEMI_RESTRICT t) {
    /* if differences of spins are needed, radii cost little, even those of alike bodies */
    if (r->parting && r->following) demi_fetch(r, count, t, 0, 1, 1, 1);
    else if (r->parting) demi_fetch(r, count, t, 0, 1, 1, 0);
    else if (r->following) demi_fetch(r, count, t, 1, 1, 0, 1);
    else demi_fetch(r, count, t, r->alike, r->turning, 0, 0);
}

/* Slip velocity, m/s, over the step just taken, in the present tangent plane. Velocity and spin
   (times arm) are means of the step, so they are projected with the normal at mid-step. It is 0 for
   a rigid motion of both bodies. */
DEM_INLINE dem_vec3 demi_slip_step(dem_vec3 normal, dem_vec3 mid, dem_vec3 gone, dem_vec3 around) {
    const dem_vec3 t = demi_sub(gone, demi_scale(mid, demi_dot(gone, mid)));
    const dem_vec3 slip = demi_add(t, demi_cross(around, mid));
    return demi_sub(slip, demi_scale(normal, demi_dot(slip, normal)));
}

/* --- stages: each runs over all pairs of a tile before the next begins. Processors then overlap
   several pairs, instead of waiting for one long chain of roots and divisions. `full` is a multiple
   of DEMI_LANES; the results of pairs that pad the last group are ignored. --- */
/* Gap, m, up to which a law is called for pair q. */
DEM_INLINE dem_real demi_tile_range(const demi_tile *t, const demi_same *s, int q, int uniform) {
    return s->range + s->range_radii*(uniform ? 2*s->radius : t->radius[0][q] + t->radius[1][q]);
}
/* Contact detection: distance, normal, overlap. ranged: the law has a range. */
DEM_INLINE void demi_touch_one(demi_tile *DEMI_RESTRICT t, const demi_same *s, int q, int uniform,
                               int ranged) {
    const dem_vec3 gap = demi_rows_at(&t->gap, q);
    const dem_real d = DEMI_SQRT(demi_dot(gap, gap)), over_d = 1/(d + DEMI_TINY);
    dem_real overlap, least = 0;
    t->length[q] = d;
    t->over_d[q] = over_d;
    demi_row_put(t->normal, q, demi_scale(gap, over_d));
    if (uniform) {
        overlap = 2*s->radius - d;
        t->deep[q] = overlap*s->inv_radius;
    } else {
        const dem_real ra = t->radius[0][q], rb = t->radius[1][q];
        overlap = ra + rb - d;
        t->deep[q] = overlap*(1/(ra < rb ? ra : rb));
        t->lean[q] = (ra - rb)/(ra + rb)*d/2;   /* the contact divides d as the radii do */
    }
    if (ranged) least = -demi_tile_range(t, s, q, uniform);
    t->touch[q] = overlap > least ? DEM_R(1) : DEM_R(0);
    t->overlap[q] = overlap > least ? overlap : 0;
}
/* Relative motion at the contact, now and over the step just taken. */
DEM_INLINE void demi_motion_one(demi_tile *DEMI_RESTRICT t, const demi_same *s, int q, int uniform,
                                int turning, int following) {
    const dem_vec3 n = demi_row(t->normal, q), rate = demi_rows_at(&t->rate, q);
    const dem_real d = t->length[q], closing = demi_dot(rate, n);
    t->closing[q] = closing;
    if (turning) {          /* la wa + lb wb, from sum and difference */
        dem_vec3 arm = demi_scale(demi_rows_at(&t->around, q), d/2);
        if (!uniform) arm = demi_add(arm, demi_scale(demi_rows_at(&t->apart, q), t->lean[q]));
        demi_row_put(t->slip, q, demi_add(demi_sub(rate, demi_scale(n, closing)),
                                          demi_cross(arm, n)));
    }
    if (following) {
        const dem_vec3 gone = demi_rows_at(&t->gone, q), turned = demi_rows_at(&t->turned, q);
        const dem_vec3 turn = demi_scale(demi_sub(gone, demi_scale(n, demi_dot(gone, n))),
                                         -t->over_d[q]);
        const dem_vec3 mid = demi_sub(n, demi_scale(turn, s->dt/2));
        dem_vec3 arm = demi_scale(turned, d/2);
        if (!uniform) arm = demi_add(arm, demi_scale(demi_rows_at(&t->parted, q), t->lean[q]));
        demi_row_put(t->turn, q, turn);
        demi_row_put(t->slip_step, q, demi_slip_step(n, mid, gone, arm));
        t->twist[q] = demi_dot(turned, n)/2;
    }
}
#define DEMI_MOTION_STAGE(NAME, UNIFORM, TURNING, FOLLOWING, RANGED) \
    DEMI_CLONES static void demi_stage_##NAME(demi_tile *DEMI_RESTRICT t, const demi_run *r, \
                                              int full) { \
        const demi_same s = r->same; \
        DEMI_ROWS(full) demi_touch_one(t, &s, q, UNIFORM, RANGED); DEMI_ROWS_END \
        DEMI_ROWS(full) demi_motion_one(t, &s, q, UNIFORM, TURNING, FOLLOWING); DEMI_ROWS_END \
    }
DEMI_MOTION_STAGE(alike_bare, 1, 0, 0, 0)
DEMI_MOTION_STAGE(mixed_bare, 0, 0, 0, 0)
DEMI_MOTION_STAGE(alike_turning, 1, 1, 0, 0)
DEMI_MOTION_STAGE(mixed_turning, 0, 1, 0, 0)
DEMI_MOTION_STAGE(alike_following, 1, 1, 1, 0)
DEMI_MOTION_STAGE(mixed_following, 0, 1, 1, 0)
DEMI_MOTION_STAGE(mixed_ranged, 0, 1, 1, 1)

#define DEMI_COEF_FETCH(PROPERTY, COEFFICIENT, UNIT) \
    c->COEFFICIENT = t->coef[DEMI_COEF_##COEFFICIENT][q];
/* Fills a dem_contact from row q; compilers leave out what the law does not use. */
DEM_INLINE void demi_tile_contact(demi_tile *DEMI_RESTRICT t, const demi_same *s, int q,
                                  dem_contact *c) {
    c->normal = demi_row(t->normal, q);
    c->overlap = t->overlap[q];
    c->range = 0;
    c->closing_speed = t->closing[q];
    c->slip = demi_row(t->slip, q);
    c->spin = demi_rows_at(&t->apart, q);
    c->slip_step = demi_row(t->slip_step, q);
    c->spin_step = demi_rows_at(&t->parted, q);
    c->normal_rate = demi_row(t->turn, q);
    c->twist = t->twist[q];
    c->dt = s->dt;
    c->kn = t->coef[DEMI_KN][q]; c->cn = t->coef[DEMI_CN][q];
    c->kt = t->coef[DEMI_KT][q]; c->ct = t->coef[DEMI_CT][q];
    c->kun = t->coef[DEMI_K_UN][q];
    DEM_LAW_COEFFICIENTS(DEMI_COEF_FETCH)
    c->friction = t->coef[DEMI_MU][q]; c->friction_static = t->coef[DEMI_MU_STATIC][q];
    c->rolling_friction = t->coef[DEMI_MU_ROLL][q];
    c->spinning_friction = t->coef[DEMI_MU_SPIN][q];
    c->sliding = t->memory[s->at_sliding][q];
    c->r_eff = t->coef[DEMI_R_EFF][q];
    c->m_eff = t->coef[DEMI_M_EFF][q];
    c->tension = s->tension;
    c->friction_load = s->friction_load;
    c->slider = s->slider;
    c->wall = 0;
}
/* Copy the contact history of pair q, `count` reals from `at` on. It is cleared if the two are
   apart. */
#define DEMI_RECALL(e) m[e] = e < count ? t->memory[at + e][q] : 0
#define DEMI_KEEP(e) if (e < count) t->memory[at + e][q] = m[e]*t->touch[q]
DEM_INLINE void demi_recall(demi_tile *DEMI_RESTRICT t, int q, int at, int count, dem_real *m) {
    int e;
    DEMI_EIGHT(DEMI_RECALL);
    for (e = 8; e < count; e++) m[e] = t->memory[at + e][q];
}
DEM_INLINE void demi_keep(demi_tile *DEMI_RESTRICT t, int q, int at, int count, const dem_real *m) {
    int e;
    DEMI_EIGHT(DEMI_KEEP);
    for (e = 8; e < count; e++) t->memory[at + e][q] = m[e]*t->touch[q];
}
#undef DEMI_RECALL
#undef DEMI_KEEP
/* Keep the energies that a law returns, for the ledger. */
DEM_INLINE void demi_normal_energy(demi_tile *DEMI_RESTRICT t, int q, const dem_contact_force *f) {
    t->part[0][q] = f->energy.dashpot*t->touch[q];
    t->part[6][q] = f->energy.sag*t->touch[q];
    t->part[1][q] = f->energy.elastic*t->touch[q];
}
DEM_INLINE void demi_tangent_energy(demi_tile *DEMI_RESTRICT t, int q, const dem_contact_force *f) {
    t->part[2][q] = f->energy.shear_work*t->touch[q];
    t->part[3][q] = f->energy.slide*t->touch[q];
    t->part[4][q] = f->energy.shear_stored*t->touch[q];
}
/* Store what a law returned, for the next stages. all: 1 adds values that few laws need, 2
   energies. */
DEM_INLINE void demi_normal_put(demi_tile *DEMI_RESTRICT t, const demi_same *s, int q,
                                const dem_contact_force *f, int all) {
    (void)s;
    t->repulsion[q] = f->normal;
    t->load[q] = f->load;
    t->kt[0][q] = f->kt;
    t->ct[q] = f->ct;
    if (!all) return;
    t->kt[1][q] = f->kt_step;
    t->slope[0][q] = f->slope;
    t->slope[1][q] = f->slope_step;
    if (all > 1) demi_normal_energy(t, q, f);
}
/* Passes what the normal law returned to the laws after it. */
DEM_INLINE void demi_normal_get(demi_tile *DEMI_RESTRICT t, int q, dem_contact_force *f) {
    demi_force_clear(f);
    f->load = t->load[q];
    f->kt = t->kt[0][q]; f->kt_step = t->kt[1][q];
    f->slope = t->slope[0][q]; f->slope_step = t->slope[1][q];
    f->ct = t->ct[q];
}
DEM_INLINE void demi_tangent_put(demi_tile *DEMI_RESTRICT t, const demi_same *s, int q,
                                 const dem_contact_force *f, int all) {
    demi_row_put(t->tangent, q, f->tangent);
    if (all < 2) return;
    t->memory[s->at_sliding][q] = f->sliding*t->touch[q];
    demi_tangent_energy(t, q, f);
}
DEM_INLINE void demi_rolling_put(demi_tile *DEMI_RESTRICT t, const demi_same *s, int q,
                                 const dem_contact_force *f, int all) {
    const int more = all > 2 && s->rolls;       /* twisting: adds to a rolling law */
    demi_row_put(t->moment, q, more ? demi_add(demi_row(t->moment, q), f->moment) : f->moment);
    t->part[5][q] = (more ? t->part[5][q] : 0) + f->energy.roll*t->touch[q];
}
/* Defines the stage of one law, whose history begins at AT. A normal or friction law has one stage
   for the usual choices (ALL 0) and one for all choices (2); a normal law has one more, for the
   usual choices with slopes (1). A normal law overwrites all fields of f that demi_normal_get
   sets. */
#define DEMI_LAW_STAGE(NAME, LAW, AT, MEMORY, ALL, PUT) \
    DEMI_CLONES static void NAME(demi_tile *DEMI_RESTRICT t, const demi_run *r, int full) { \
        demi_same s = r->same; \
        if ((ALL) >= 2 && !r->usual) DEMI_LAW_LOOP(LAW, AT, MEMORY, ALL, PUT, (void)0) \
        else { \
            s.at_sliding = DEMI_MEMORY; \
            DEMI_LAW_LOOP(LAW, AT, MEMORY, ALL, PUT, demi_contact_usual(&c)) \
        } \
    }
#define DEMI_LAW_LOOP(LAW, AT, MEMORY, ALL, PUT, USUAL) \
    DEMI_ROWS(full) \
        dem_contact c; dem_contact_force f; dem_real m[DEMI_MEMORY]; \
        demi_tile_contact(t, &s, q, &c); \
        USUAL; \
        demi_normal_get(t, q, &f); \
        demi_recall(t, q, AT, MEMORY, m); \
        dem_law_##LAW(&c, m, &f); \
        demi_keep(t, q, AT, MEMORY, m); \
        PUT(t, &s, q, &f, ALL); \
    DEMI_ROWS_END
#define DEMI_NORMAL_STAGES(KIND, LAW, MEMORY, VECTORS, TRAITS, TEXT) \
    DEMI_LAW_STAGE(demi_stage_##LAW, LAW, s.at_normal, MEMORY, 0, demi_normal_put) \
    DEMI_LAW_STAGE(demi_stage_##LAW##_precise, LAW, s.at_normal, MEMORY, 1, demi_normal_put) \
    DEMI_LAW_STAGE(demi_stage_##LAW##_all, LAW, s.at_normal, MEMORY, 2, demi_normal_put)
#define DEMI_TANGENT_STAGES(KIND, LAW, MEMORY, VECTORS, TRAITS, TEXT) \
    DEMI_LAW_STAGE(demi_stage_##LAW, LAW, 0, MEMORY, 0, demi_tangent_put) \
    DEMI_LAW_STAGE(demi_stage_##LAW##_all, LAW, 0, MEMORY, 2, demi_tangent_put)
#define DEMI_ROLLING_STAGES(KIND, LAW, MEMORY, VECTORS, TRAITS, TEXT) \
    DEMI_LAW_STAGE(demi_stage_##LAW, LAW, s.at_rolling, MEMORY, 2, demi_rolling_put)
DEMI_LAW_STAGE(demi_stage_twist, twist, s.at_twisting, 1, 3, demi_rolling_put)
DEMI_NORMAL_LAWS(DEMI_NORMAL_STAGES)
DEMI_TANGENT_LAWS(DEMI_TANGENT_STAGES)
DEMI_ROLLING_LAWS(DEMI_ROLLING_STAGES)

/* Force and torques of pair q; zero if the two are apart. */
DEM_INLINE void demi_answer_one(demi_tile *DEMI_RESTRICT t, int q, dem_real repulsion,
                                dem_vec3 tangent, dem_vec3 moment, int uniform, int turning,
                                int parting) {
    const dem_real touch = t->touch[q];
    const dem_vec3 n = demi_row(t->normal, q);
    tangent = demi_scale(tangent, touch);
    demi_row_put(t->force, q, demi_sub(tangent, demi_scale(n, repulsion*touch)));
    if (turning) {
        const dem_vec3 across = demi_cross(n, tangent);
        const dem_real half = t->length[q]/2, lean = uniform ? 0 : t->lean[q];
        if (parting) {
            moment = demi_scale(moment, touch);
            demi_row_put(t->torque[0], q, demi_add(demi_scale(across, half + lean), moment));
            demi_row_put(t->torque[1], q, demi_sub(demi_scale(across, half - lean), moment));
        } else demi_row_put(t->torque[0], q, demi_scale(across, half));  /* the same on both */
    }
}
#define DEMI_ANSWER_STAGE(NAME, UNIFORM, TURNING, PARTING, MOMENT) \
    DEMI_CLONES static void demi_stage_##NAME(demi_tile *DEMI_RESTRICT t, const demi_run *r, \
                                              int full) { \
        (void)r; \
        DEMI_ROWS(full) \
            demi_answer_one(t, q, t->repulsion[q], \
                            TURNING ? demi_row(t->tangent, q) : demi_v(0, 0, 0), \
                            MOMENT ? demi_row(t->moment, q) : demi_v(0, 0, 0), \
                            UNIFORM, TURNING, PARTING); \
        DEMI_ROWS_END \
    }
DEMI_ANSWER_STAGE(answer_bare, 1, 0, 0, 0)
DEMI_ANSWER_STAGE(answer_alike, 1, 1, 0, 0)
DEMI_ANSWER_STAGE(answer_mixed, 0, 1, 1, 0)
DEMI_ANSWER_STAGE(answer_alike_rolling, 1, 1, 1, 1)
DEMI_ANSWER_STAGE(answer_mixed_rolling, 0, 1, 1, 1)

/* Returns the stage of force and torques. rolls: the laws return moments. */
static demi_stage demi_answer_choose(const demi_run *r, int rolls) {
    return !r->turning ? demi_stage_answer_bare
        : rolls ? r->alike ? demi_stage_answer_alike_rolling : demi_stage_answer_mixed_rolling
        : r->alike ? demi_stage_answer_alike : demi_stage_answer_mixed;
}

/* Defines a stage with all laws, force and torques, for the most common scenes. History: FRICTION
   reals of friction, then those of rolling. */
#define DEMI_WHOLE_STAGE(NAME, NORMAL, TANGENT, FRICTION, ROLLING, MEMORY, UNIFORM, TURNING, \
                         ROLLS, LEDGER) \
    DEMI_CLONES static void demi_stage_##NAME(demi_tile *DEMI_RESTRICT t, const demi_run *r, \
                                              int full) { \
        const demi_same s = r->same; \
        DEMI_ROWS(full) \
            dem_contact c; dem_contact_force f; dem_real m[DEMI_MEMORY]; \
            demi_tile_contact(t, &s, q, &c); \
            demi_contact_usual(&c); \
            demi_force_clear(&f); \
            NORMAL(&c, 0, &f); \
            demi_recall(t, q, 0, MEMORY, m); \
            TANGENT(&c, m, &f); \
            ROLLING(&c, m + (FRICTION), &f); \
            demi_keep(t, q, 0, MEMORY, m); \
            demi_answer_one(t, q, f.normal, f.tangent, f.moment, UNIFORM, TURNING, \
                            (TURNING && !(UNIFORM)) || (ROLLS)); \
            if (LEDGER) { demi_normal_energy(t, q, &f); demi_tangent_energy(t, q, &f); } \
            if ((LEDGER) && (ROLLS)) t->part[5][q] = f.energy.roll*t->touch[q]; \
        DEMI_ROWS_END \
    }
#ifndef DEM_NO_SPECIALIZE
#define DEMI_NO_LAW(c, m, f) ((void)0)
DEMI_WHOLE_STAGE(hertz_alone, dem_law_hertz, DEMI_NO_LAW, 0, DEMI_NO_LAW, 0, 1, 0, 0, 0)
#define DEMI_WHOLE_SPRING(NAME, UNIFORM, LEDGER) \
    DEMI_WHOLE_STAGE(NAME, dem_law_hertz, dem_law_spring, 3, DEMI_NO_LAW, 3, UNIFORM, 1, 0, \
                     LEDGER)
#define DEMI_WHOLE_ROLLING(NAME, UNIFORM, LEDGER) \
    DEMI_WHOLE_STAGE(NAME, dem_law_hertz, dem_law_spring, 3, dem_law_roll_epsd, 6, UNIFORM, 1, 1, \
                     LEDGER)
DEMI_WHOLE_SPRING(spring_alike, 1, 0)
DEMI_WHOLE_SPRING(spring_mixed, 0, 0)
DEMI_WHOLE_SPRING(spring_alike_ledger, 1, 1)
DEMI_WHOLE_SPRING(spring_mixed_ledger, 0, 1)
DEMI_WHOLE_ROLLING(rolling_alike, 1, 0)
DEMI_WHOLE_ROLLING(rolling_mixed, 0, 0)
DEMI_WHOLE_ROLLING(rolling_alike_ledger, 1, 1)
DEMI_WHOLE_ROLLING(rolling_mixed_ledger, 0, 1)
#endif
