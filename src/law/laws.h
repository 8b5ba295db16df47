/* ---------------------------------------------------------------------------------------------
   >>laws
   Tables of the built-in contact laws, one row each. The law functions are in >>api, where
   user-defined laws may call them. A contact force is the sum of a normal law, a friction law and a
   rolling law; the last two may be absent. The contact history consists of the reals of these
   three, in the order friction, rolling, normal. Each row says how many of its reals are vectors.
   >>add-law: (1) a function dem_law_... and, at the end of its enum, a constant in >>api; (2) a row
   at the end of its list here with its traits (DEMI_SIZED, DEMI_MIDDLE: optional inputs that it
   needs), and for a normal law its coefficients above; (3) a test in tests/. docs/extending.md
   walks through these steps, and `make recipes` tests that page.
   --------------------------------------------------------------------------------------------- */
/* Traits of a law. */
enum {
    DEMI_LINEAR = 0,               /* force ~ overlap; the stiffness may be given */
    DEMI_HERTZIAN = 1,             /* force ~ overlap^(3/2), stiffness ~ sqrt(R) */
    DEMI_BRANCHED = 2,             /* unloads along a second line and may adhere: kun, kad */
    DEMI_MIDDLE = 4,               /* reads slopes or kt_step, which are NaN for other laws */
    DEMI_SPRUNG = 8,               /* rolling spring, which the time step must resolve */
    DEMI_SIZED = 16                /* reads r_eff or m_eff, which are NaN for other laws */
};
/* Input of the coefficients of a normal law: effective moduli (Pa), radius (m) and damping ratio of
   one contact, and the speed (m/s) of a likely impact. M: kg, the mass that a stiffness may depend
   on. M is constant while two bodies touch. The effective mass m at a contact of nonspherical
   bodies changes as they rotate, and a stiffness that followed it would create energy (up to 0.1 of
   an impact's). Dashpots follow sqrt(m): their coefficient is cn + cn_root sqrt(m), and ct
   likewise. */
typedef struct demi_scales {
    double E, G, R, M, beta, speed;
    const dem_pair *pair;
} demi_scales;
#define DEMI_COEF_DOUBLE(PROPERTY, COEFFICIENT, UNIT) double COEFFICIENT;
typedef struct demi_coefs {
    double kn, cn, kt, ct, kun, cn_root, ct_root;
    DEM_LAW_COEFFICIENTS(DEMI_COEF_DOUBLE)
} demi_coefs;
/* F = kn d^(3/2) + cn d^(1/4) v,  kn = 4/3 E* sqrt(R*),  cn = 2 sqrt(5/6) beta sqrt(2 E* sqrt(R*)
   m*),  kt = 8 G* sqrt(R*) (times d^(1/2)),  ct = 2 sqrt(5/6) beta sqrt(8 G* sqrt(R*) m*)
   [TSU92, MIL] */
static void demi_coefs_hertz(const demi_scales *s, demi_coefs *k) {
    const double root = sqrt(s->R);
    k->kn = 4*s->E*root/3;
    k->cn_root = 2*sqrt(5.0/6)*s->beta*sqrt(2*s->E*root);
    k->kt = 8*s->G*root;
    k->ct_root = 2*sqrt(5.0/6)*s->beta*sqrt(8*s->G*root);
}
/* F = kn d + cn v,  kn = (320/81 M v^2 E*^4 R*^2)^(1/5) [DIM04] unless given,
   cn = 2 beta sqrt(kn m*) unless given,  kt = ratio kn,  ct = 2 beta sqrt(kt m*) */
static void demi_coefs_linear(const demi_scales *s, demi_coefs *k) {
    const double E = s->E, R = s->R, M = s->M, v = s->speed;
    const dem_pair *p = s->pair;
    k->kn = p->stiffness > 0 ? (double)p->stiffness : demi_pow(320.0/81*M*v*v*E*E*E*E*R*R, 0.2);
    if (p->normal_damping > 0) k->cn = (double)p->normal_damping;
    else k->cn_root = 2*s->beta*sqrt(k->kn);
    k->kt = k->kn*(double)p->stiffness_ratio;
    k->ct_root = 2*s->beta*sqrt(k->kt);
}
/* kn, kt, ct as linear,  kun = kn/e^2 ([ALK07] eq 2.43),  kad as given,  cn = 0 unless given */
static void demi_coefs_hysteretic(const demi_scales *s, demi_coefs *k) {
    const double e = (double)s->pair->restitution;
    demi_coefs_linear(s, k);
    k->cn = (double)s->pair->normal_damping;
    k->cn_root = 0;
    k->kun = k->kn/(e*e);
    k->kad = (double)s->pair->stiffness_adhesion;
}
/* Fields of a row: constant, function, reals of contact history, number of vectors among them
   (first), traits, name in reports. The coefficients of a normal law are demi_coefs_... */
#define DEMI_NORMAL_LAWS(X) \
    X(DEM_NORMAL_HERTZ,             hertz,            0, 0, DEMI_HERTZIAN, "Hertz") \
    X(DEM_NORMAL_LINEAR,            linear,           0, 0, DEMI_LINEAR, "linear") \
    X(DEM_NORMAL_HYSTERETIC,        hysteretic,       1, 0, DEMI_BRANCHED, "hysteretic") \
    /* the last */
#define DEMI_TANGENT_LAWS(X) \
    X(DEM_TANGENT_VISCOUS,          viscous,          0, 0, 0, "viscous") \
    X(DEM_TANGENT_STEP,             step,             0, 0, 0, "step") \
    X(DEM_TANGENT_SPRING,           spring,           3, 1, 0, "spring") \
    X(DEM_TANGENT_MINDLIN,          mindlin,          4, 1, DEMI_MIDDLE, "Mindlin") \
    X(DEM_TANGENT_MINDLIN_RESCALED, mindlin_rescaled, 4, 1, DEMI_MIDDLE, "Mindlin, rescaled") \
    /* the last */
#define DEMI_ROLLING_LAWS(X) \
    X(DEM_ROLLING_STEP,             roll_step,        0, 0, DEMI_SIZED, "step") \
    X(DEM_ROLLING_CONSTANT,         roll_constant,    3, 1, DEMI_SIZED, "constant torque") \
    X(DEM_ROLLING_EPSD,             roll_epsd,        3, 1, \
      DEMI_SPRUNG | DEMI_SIZED | DEMI_MIDDLE, "EPSD") \
    /* the last */

/* A row of the tables. */
typedef struct demi_law_row {
    int kind;                      /* the enum constant; -1 ends a table */
    dem_law_fn law;                /* null for "none" and "auto" */
    int memory, vectors, traits;   /* reals of history; vectors that they begin with; bits */
    const char *name;
    void (*coefs)(const demi_scales *s, demi_coefs *k);    /* of a normal law; sets what is not 0 */
} demi_law_row;
#define DEMI_NORMAL_ROW(KIND, LAW, MEMORY, VECTORS, TRAITS, NAME) \
    {KIND, dem_law_##LAW, MEMORY, VECTORS, TRAITS, NAME, demi_coefs_##LAW},
#define DEMI_LAW_ROW(KIND, LAW, MEMORY, VECTORS, TRAITS, NAME) \
    {KIND, dem_law_##LAW, MEMORY, VECTORS, TRAITS, NAME, 0},
static const demi_law_row demi_normal_laws[] = {DEMI_NORMAL_LAWS(DEMI_NORMAL_ROW)
    {-1, 0, 0, 0, 0, 0, 0}};
static const demi_law_row demi_tangent_laws[] = {{DEM_TANGENT_AUTO, 0, 0, 0, 0, "auto", 0},
    {DEM_TANGENT_NONE, 0, 0, 0, 0, "none", 0}, DEMI_TANGENT_LAWS(DEMI_LAW_ROW)
    {-1, 0, 0, 0, 0, 0, 0}};
static const demi_law_row demi_rolling_laws[] = {{DEM_ROLLING_AUTO, 0, 0, 0, 0, "auto", 0},
    {DEM_ROLLING_NONE, 0, 0, 0, 0, "none", 0}, DEMI_ROLLING_LAWS(DEMI_LAW_ROW)
    {-1, 0, 0, 0, 0, 0, 0}};
/* Returns the law of the desc, with AUTO replaced by the law that it means if a pair needs one.
   Impulses have no laws: with them it is AUTO, so that a coefficient alone decides. */
static int demi_tangent_meant(const dem_world *w) {
    return w->desc.tangent_law == DEM_TANGENT_AUTO || !demi_response_is(w, DEMI_LAWS)
        ? DEM_TANGENT_SPRING : (int)w->desc.tangent_law;
}
static int demi_rolling_meant(const dem_world *w) {
    return w->desc.rolling_law == DEM_ROLLING_AUTO || !demi_response_is(w, DEMI_LAWS)
        ? DEM_ROLLING_EPSD : (int)w->desc.rolling_law;
}
/* True if the normal law of the desc has this trait. */
DEM_INLINE int demi_normal_is(const dem_world *w, int trait) {
    return (demi_normal_laws[w->desc.normal_law].traits & trait) != 0;
}
/* True if built-in laws own the contact history, laid out as in w->laws. */
static int demi_laws_keep(const dem_world *w) {
    return !w->desc.law && demi_response_is(w, DEMI_LAWS);
}
/* True if a law in force reads r_eff or m_eff; a user-defined law may. */
static int demi_laws_sized(const dem_world *w) {
    return w->desc.law || w->effects.twisting ||
        ((w->laws.normal->traits | w->laws.tangent->traits | w->laws.rolling->traits) & DEMI_SIZED);
}
/* True if a law in force reads slopes of the normal force or the stiffness of mid-step. */
static int demi_laws_precise(const dem_world *w) {
    return ((w->laws.tangent->traits | w->laws.rolling->traits) & DEMI_MIDDLE) != 0;
}
/* True if the table has a law of this kind. */
static int demi_law_known(const demi_law_row *rows, int kind) {
    int k;
    for (k = 0; rows[k].kind >= 0; k++) if (k == kind) return 1;
    return 0;
}

/* Appends a real to contact histories of `memory` reals, if needed, and returns its index;
   DEMI_MEMORY if not. */
static int demi_laws_append(int *memory, int needed) {
    return needed ? (*memory)++ : (int)DEMI_MEMORY;
}
/* True if laws in force return moments. */
static int demi_laws_roll(const dem_world *w) {
    return w->desc.law || w->laws.rolling->law || w->effects.twisting;
}
/* Sets the laws in force and lays out the contact history. sticks, twisting: 1 if a pair has static
   or spinning friction. */
static void demi_laws_set(demi_laws *laws, int normal, int tangent, int rolling, int sticks,
                          int twisting) {
    laws->normal = &demi_normal_laws[normal];
    laws->tangent = &demi_tangent_laws[tangent];
    laws->rolling = &demi_rolling_laws[rolling];
    laws->at_rolling = laws->tangent->memory;
    laws->at_normal = laws->at_rolling + laws->rolling->memory;
    laws->memory = laws->at_normal + laws->normal->memory;
    laws->vectors = ((1 << 3*laws->tangent->vectors) - 1) |
                    ((1 << 3*laws->rolling->vectors) - 1) << laws->at_rolling |
                    ((1 << 3*laws->normal->vectors) - 1) << laws->at_normal;
    laws->at_sliding = demi_laws_append(&laws->memory, sticks && laws->tangent->law);
    laws->at_twisting = demi_laws_append(&laws->memory, twisting);
}
/* Returns the number of reals of a contact history that users and digests see. */
static int demi_memory_told(const dem_world *w) {
    return w->memory_stride - (w->laws.at_grip < DEMI_MEMORY);
}
/* Clears a result before the law is called. Member by member, because a memset would keep the
   struct in memory and prevent vectorisation. */
DEM_INLINE void demi_force_clear(dem_contact_force *f) {
    f->tangent = f->moment = demi_v(0, 0, 0);
    f->normal = f->elastic = f->load = f->slope = f->slope_step = 0;
    f->kt = f->kt_step = f->ct = f->sliding = 0;
    f->energy.dashpot = f->energy.sag = f->energy.elastic = f->energy.shear_work = 0;
    f->energy.slide = f->energy.shear_stored = f->energy.roll = 0;
}
/* Clears the description of a contact, member by member for the same reason. */
DEM_INLINE void demi_who_clear(dem_contact_who *who) {
    who->a.slot = who->a.generation = who->b.slot = who->b.generation = 0;
    who->radius_a = who->radius_b = who->mass_a = who->mass_b = 0;
    who->point = demi_v(0, 0, 0);
    who->time = 0;
    who->reals_a = who->reals_b = 0;
    who->rate_a = who->rate_b = 0;
}
/* Gives the law the user-defined numbers of body a and of body b or the wall, and a place for their
   rates: two rows of DEM_BODY_REALS, set to 0 here. b < 0: a wall. */
static void demi_who_reals(const dem_world *w, int a, int b, int wall, dem_real *rates,
                           dem_contact_who *who) {
    const int n = w->bodies.real_count;
    int k;
    if (!n) return;
    for (k = 0; k < 2*DEM_BODY_REALS; k++) rates[k] = 0;
    who->reals_a = w->bodies.reals + n*a;
    who->reals_b = b >= 0 ? w->bodies.reals + n*b : w->walls[wall].reals;
    who->rate_a = rates;
    who->rate_b = rates + DEM_BODY_REALS;
}
/* Sets tension, friction load, slider and static friction to the defaults of a desc.
   demi_laws_usual: true if the world uses these defaults. */
DEM_INLINE void demi_contact_usual(dem_contact *c) {
    c->tension = DEM_TENSION_ALLOWED;
    c->friction_load = DEM_LOAD_REPULSIVE;
    c->slider = DEM_SLIDER_PARALLEL;
    c->friction_static = c->friction;
    c->sliding = 0;
}
static int demi_laws_usual(const dem_world *w) {
    return w->desc.tension == DEM_TENSION_ALLOWED && w->desc.friction_load == DEM_LOAD_REPULSIVE &&
           w->desc.slider == DEM_SLIDER_PARALLEL && w->laws.at_sliding == DEMI_MEMORY;
}
/* Computes the force of one contact by the laws in force or by the user-defined law. memory: the
   whole contact history, with the sliding state. */
static void demi_law(const dem_world *w, dem_contact *c, dem_real *memory, dem_contact_force *f) {
    const demi_laws *laws = &w->laws;
    const int slides = laws->at_sliding < DEMI_MEMORY;
    demi_force_clear(f);
    c->sliding = slides ? memory[laws->at_sliding] : 0;
    if (w->desc.law) DEMI_USER(w, "the evaluation of contacts", 1, w->desc.law(c, memory, f))
    else {
        laws->normal->law(c, memory + laws->at_normal, f);
        if (laws->tangent->law) laws->tangent->law(c, memory, f);
        if (laws->rolling->law) laws->rolling->law(c, memory + laws->at_rolling, f);
        if (w->effects.twisting) dem_law_twist(c, memory + laws->at_twisting, f);
    }
    if (slides) memory[laws->at_sliding] = f->sliding;
}
/* A contact linearized about an overlap, for small motions. Stiffness: normal and tangential, N/m,
   rolling, N m. Damping: likewise, N s/m and N m s. */
typedef struct demi_stiffness { double k, kt, kr, c, ct, cr; } demi_stiffness;
/* Returns k and c of the built-in normal law at an overlap, m, during loading; the rest is 0. */
static demi_stiffness demi_stiffness_normal(const dem_world *w, const dem_real *coef,
                                            double overlap) {
    demi_stiffness s = {0, 0, 0, 0, 0, 0};
    s.k = (double)coef[DEMI_KN];
    s.c = (double)coef[DEMI_CN];
    if (demi_normal_is(w, DEMI_HERTZIAN)) {
        s.k *= 1.5*sqrt(overlap);
        s.c *= sqrt(sqrt(overlap));
    }
    return s;
}
