/* ---------------------------------------------------------------------------------------------
   >>materials
   Materials, the pair table and the coefficients of contacts. A material has density, Young's
   modulus, Poisson's ratio, restitution and friction. The pair table holds the properties of every
   two materials. demi_coefficients computes the coefficients of a law from a pair and two radii.
   Restitution is the input; damping is derived from it.
   --------------------------------------------------------------------------------------------- */
/* `zero` of Young's modulus and restitution (>>rows): they may be 0 with impulses, or if the
   stiffness in field `other` is set and the normal law has a trait in `kinds` (kinds 0: any law
   except Hertz's). kinds < 0: the field acts with impulses only and must be 0 with springs. */
static int demi_zero_law(const dem_world *w, const void *item, const demi_field_row *r) {
    const int acts = r->kinds > 0 ? demi_normal_is(w, r->kinds) : !demi_normal_is(w, DEMI_HERTZIAN);
    if (r->kinds < 0) return demi_response_is(w, DEMI_LAWS) ? DEMI_0_ALONE : DEMI_0_TOO;
    return !demi_response_is(w, DEMI_LASTING) ||
        (acts && r->other && demi_row_read(r - r->other, item, 0) > 0) ? DEMI_0_TOO : DEMI_0_NOT;
}
/* `zero` of stiffness_unloading: it must be 0 unless the stiffness is set. */
static int demi_zero_unloading(const dem_world *w, const void *item, const demi_field_row *r) {
    (void)w; (void)r;
    return ((const dem_material_desc *)item)->stiffness > 0 ? DEMI_0_TOO : DEMI_0_ALONE;
}
#define DEMI_SI(field, how, unit) DEMI_LIMITED(DEMI_OF, field, 'r', how, DEMI_MOST, unit)
#define DEMI_RATIO(field) DEMI_LIMITED(DEMI_OF, field, 'r', DEMI_FROM, DEMI_MOST_RATIO, "")
#define DEMI_ROW_IF(field, how, most, unit, words, other, kinds, zero) \
    DEMI_LIMITED_IF(DEMI_OF, field, 'r', how, most, unit, words, other, kinds, zero)
#define DEMI_STATIC DEMI_ROW_IF(friction_static, DEMI_FROM, DEMI_MOST_RATIO, "", \
    "where the default is 0 (the same as the sliding friction)", 1, 0, 0)
#define DEMI_PROPERTY_ROW(PROPERTY, COEFFICIENT, UNIT) DEMI_SI(PROPERTY, DEMI_FROM, UNIT),
#define DEMI_OF dem_material_desc
static const demi_field_row demi_material_rows[] = {
    DEMI_SI(density, DEMI_OVER, "kg/m3"),
    DEMI_ROW_IF(young, DEMI_OVER, DEMI_MOST, "Pa", 0, -6, 0, demi_zero_law),
    DEMI_LIMITED(DEMI_OF, poisson, 'r', DEMI_FROM | DEMI_UNDER, 0.5, ""),
    DEMI_ROW_IF(restitution, DEMI_OVER, 1, "", 0, -6, DEMI_BRANCHED, demi_zero_law),
    DEMI_RATIO(friction), DEMI_STATIC, DEMI_RATIO(rolling_friction),
    DEMI_SI(stiffness, DEMI_FROM, "N/m"), DEMI_RATIO(stiffness_ratio),
    DEMI_ROW_IF(stiffness_unloading, DEMI_FROM, DEMI_MOST, "N/m", "which must then be set", 2, 0,
                demi_zero_unloading), DEM_LAW_COEFFICIENTS(DEMI_PROPERTY_ROW) DEMI_ROW_END};
#undef DEMI_OF
#define DEMI_OF dem_pair
#define DEMI_IMPULSES_ALONE(field, unit) DEMI_ROW_IF(field, DEMI_FROM, DEMI_MOST, unit, \
    "and 0 where springs answer (desc.response)", 0, -1, demi_zero_law)
static const demi_field_row demi_pair_rows[] = {
    DEMI_ROW_IF(young_eff, DEMI_OVER, DEMI_MOST, "Pa", 0, -6, 0, demi_zero_law),
    DEMI_SI(shear_eff, DEMI_FROM, "Pa"),
    DEMI_ROW_IF(restitution, DEMI_OVER, 1, "", 0, 0, 0, demi_zero_law),
    DEMI_RATIO(friction), DEMI_STATIC, DEMI_RATIO(rolling_friction),
    DEMI_SI(stiffness, DEMI_FROM, "N/m"), DEMI_RATIO(stiffness_ratio), DEMI_RATIO(tangent_damping),
    DEMI_SI(normal_damping, DEMI_FROM, "N s/m"),
    DEMI_SI(spinning_friction, DEMI_FROM, ""), DEMI_IMPULSES_ALONE(cohesion, "N"),
    DEMI_IMPULSES_ALONE(compliance, "m/N"), DEM_LAW_COEFFICIENTS(DEMI_PROPERTY_ROW)
    DEMI_LIMITED(DEMI_OF, ignored, 'i', DEMI_FROM, 1, ""), DEMI_ROW_END};
#undef DEMI_OF
/* Checks a desc. A hysteretic law may not have a restitution that contradicts its stiffnesses. */
static dem_result demi_material_check(dem_world *w, const char *call, const dem_material_desc *d) {
    if (demi_rows_check(w, call, demi_material_rows, d, "", "set it in the desc before the call"))
        return DEM_ERROR_ARGUMENT;
    if (demi_normal_is(w, DEMI_BRANCHED) && d->stiffness_unloading > 0 && d->restitution > 0 &&
        fabs((double)d->restitution*(double)d->restitution*
             (double)d->stiffness_unloading/(double)d->stiffness - 1) > 1e-3)
        return demi_refuse(w, call, "restitution is %g, but sqrt(stiffness/stiffness_unloading) is "
                           "%g; give one of the two and leave the other 0", (double)d->restitution,
                           sqrt((double)d->stiffness/(double)d->stiffness_unloading));
    return DEM_OK;
}

#define DEMI_PROPERTY_MIX(PROPERTY, COEFFICIENT, UNIT) \
    p.PROPERTY = (dem_real)sqrt((double)a->PROPERTY*(double)b->PROPERTY);
/* Returns the properties of a pair of materials: moduli from compliances in series, as in Hertz's
   theory, springs in series for stiffnesses, geometric means for the rest. */
static dem_pair demi_mix(const dem_material_desc *a, const dem_material_desc *b) {
    dem_pair p;
    const double Ea = (double)a->young, Eb = (double)b->young, na = (double)a->poisson;
    const double nb = (double)b->poisson;
    const int sticks = a->friction_static > 0 || b->friction_static > 0;
    const double sa = (double)(a->friction_static > 0 ? a->friction_static : a->friction);
    const double sb = (double)(b->friction_static > 0 ? b->friction_static : b->friction);
    memset(&p, 0, sizeof p);
    if (Ea > 0 && Eb > 0) {
        p.young_eff = (dem_real)(1/((1 - na*na)/Ea + (1 - nb*nb)/Eb));
        p.shear_eff = (dem_real)(1/((2 - na)*2*(1 + na)/Ea + (2 - nb)*2*(1 + nb)/Eb));
    }
    p.restitution = (dem_real)sqrt((double)a->restitution*(double)b->restitution);
    p.friction = (dem_real)sqrt((double)a->friction*(double)b->friction);
    p.friction_static = sticks ? (dem_real)sqrt(sa*sb) : 0;   /* 0: as sliding friction */
    p.rolling_friction = (dem_real)sqrt((double)a->rolling_friction*(double)b->rolling_friction);
    p.tangent_damping = 1;
    DEM_LAW_COEFFICIENTS(DEMI_PROPERTY_MIX)
    /* twice the springs in series, so that equal materials give their own value */
    if (a->stiffness > 0 && b->stiffness > 0)
        p.stiffness = (dem_real)(2*((double)a->stiffness*(double)b->stiffness)/
                                 ((double)a->stiffness + (double)b->stiffness));
    /* one material has only a modulus, the other only a stiffness */
    else if (p.young_eff <= 0)
        p.stiffness = DEMI_MAX(a->stiffness, b->stiffness);
    if (a->stiffness_ratio > 0 && b->stiffness_ratio > 0)
        p.stiffness_ratio = DEMI_SQRT(a->stiffness_ratio*b->stiffness_ratio);
    else                                        /* Mindlin's 2(1-nu)/(2-nu), for the mean nu */
        p.stiffness_ratio = (dem_real)(2*(1 - (na + nb)/2)/(2 - (na + nb)/2));
    return p;
}

/* Damping ratio that gives restitution e: beta = -ln e / sqrt(pi^2 + ln^2 e). */
static double demi_damping_ratio(double e) {
    const double l = demi_log(e);
    return -l/sqrt(DEMI_PI*DEMI_PI + l*l);
}
/* Restitution at damping ratio beta if the contact ends at zero force [SP07]:
   exp(-beta/w acos(2 beta^2 - 1)), w = sqrt(1 - beta^2); above critical damping with hyperbolic
   functions. Valid for the linear law and, with the dashpot of [TSU92], for Hertz. */
static double demi_restitution_clipped(double beta) {
    const double w = sqrt(fabs(1 - beta*beta));
    if (beta < 1 - 1e-9) return demi_exp(-beta/w*demi_acos(2*beta*beta - 1));
    if (beta > 1 + 1e-9) return demi_exp(-beta/w*demi_log((beta + w)/(beta - w)));
    return demi_exp(-2.0);
}
/* Damping ratio that gives restitution e with this choice of desc.tension. */
static double demi_damping_for(double e, dem_tension tension) {
    double lo = 0, hi = 1;
    int i;
    if (tension != DEM_TENSION_COMPENSATED || e >= 1) return demi_damping_ratio(e);
    while (demi_restitution_clipped(hi) > e && hi < 1e6) hi *= 2;
    for (i = 0; i < 100; i++) {                 /* bisection: it falls with beta */
        const double mid = (lo + hi)/2;
        if (demi_restitution_clipped(mid) > e) lo = mid;
        else hi = mid;
    }
    return (lo + hi)/2;
}
/* Marks the properties of pairs and the time step as outdated: the next step rebuilds the lists. */
static void demi_pairs_changed(dem_world *w) {
    w->stage.pairs_changed = 1;
    demi_dt_outdated(w);
}

/* Stores the properties of materials i and j in both orders. Also computes their damping ratio,
   once, because it may need a bisection (demi_damping_for). */
static void demi_pair_put(dem_world *w, int i, int j, const dem_pair *p) {
    demi_pair *pair = &w->pairs[i*DEMI_MATERIALS + j];
    pair->given = *p;                           /* `own` stays */
    pair->damping = demi_response_is(w, DEMI_LASTING)
        ? demi_damping_for((double)p->restitution, w->desc.tension) : 0;
    w->pairs[j*DEMI_MATERIALS + i] = *pair;
}
/* True if bodies and walls of materials a and b (indices) pass through each other. */
DEM_INLINE int demi_ignores(const dem_world *w, int a, int b) {
    return w->pairs[a*DEMI_MATERIALS + b].given.ignored;
}
/* The materials that ignore material b, bit i for that of index i. */
static uint64_t demi_ignorers(const dem_world *w, int b) {
    uint64_t all = 0;
    int i;
    for (i = 0; i < w->material_count; i++) all |= (uint64_t)demi_ignores(w, i, b) << i;
    return all;
}
/* Static friction of a pair: the sliding friction if it is unset or lower. */
static dem_real demi_static_friction(const dem_world *w, int a, int b) {
    const dem_pair *p = &w->pairs[a*DEMI_MATERIALS + b].given;
    return DEMI_MAX(p->friction, p->friction_static);
}
DEM_API dem_material dem_material_add(dem_world *w, const dem_material_desc *desc) {
    if (demi_null(w, __func__, desc, "desc")) return demi_no_material;
    dem_material id; int i, n = w->material_count;
    id.id = 0;
    if (demi_material_check(w, __func__, desc) != DEM_OK) return id;
    if (n == DEMI_MATERIALS) {
        demi_refuse(w, __func__, "there are %d materials already, which is the limit; "
                    "reuse one of them", n);
        return id;
    }
    w->materials[n] = *desc;
    if (!(desc->restitution > 0) && demi_response_is(w, DEMI_LASTING)) /* by the stiffnesses */
        w->materials[n].restitution = DEMI_SQRT(desc->stiffness/desc->stiffness_unloading);
    w->material_count = n + 1;
    for (i = 0; i <= n; i++) {
        const dem_pair pair = demi_mix(&w->materials[i], &w->materials[n]);
        demi_pair_put(w, i, n, &pair);
    }
    demi_built(w, __func__);
    id.id = n + 1;
    return id;
}

/* Sets *index to the index of a material, or fails in the name of `call`. */
static dem_result demi_material_index(dem_world *w, const char *call, dem_material m, int *index) {
    if (m.id < 1 || m.id > w->material_count)
        return demi_refuse(w, call, "material %d does not exist, there are %d; add it with "
                           "dem_material_add and check the id that this returns", (int)m.id,
                           w->material_count);
    *index = m.id - 1;
    return DEM_OK;
}

DEM_API dem_result dem_material_get(const dem_world *world, dem_material material,
                                    dem_material_desc *desc) {
    if (demi_null_look(world, __func__, desc, "desc")) return DEM_ERROR_ARGUMENT;
    int m = 0;
    if (demi_material_index((dem_world *)world, __func__, material, &m)) return DEM_ERROR_ARGUMENT;
    *desc = world->materials[m];
    return DEM_OK;
}
DEM_API dem_result dem_material_set(dem_world *w, dem_material material,
                                    const dem_material_desc *desc) {
    if (demi_null(w, __func__, desc, "desc")) return DEM_ERROR_ARGUMENT;
    dem_material_desc before;
    int m = 0, i;
    if (demi_material_index(w, __func__, material, &m) ||
        demi_material_check(w, __func__, desc) != DEM_OK) return DEM_ERROR_ARGUMENT;
    before = w->materials[m];
    if (desc->density < before.density || desc->density > before.density)
        return demi_refuse(w, __func__, "density of material %d is %g kg/m3, must stay "
                           "%g, because masses of bodies were computed from it; add another "
                           "material", m + 1, (double)desc->density, (double)before.density);
    w->materials[m] = *desc;
    if (!(desc->restitution > 0) && demi_response_is(w, DEMI_LASTING)) /* by the stiffnesses */
        w->materials[m].restitution = DEMI_SQRT(desc->stiffness/desc->stiffness_unloading);
    for (i = 0; i < w->material_count; i++) {
        const dem_pair now = demi_mix(&w->materials[i], &w->materials[m]);
        if (!w->pairs[i*DEMI_MATERIALS + m].own) demi_pair_put(w, i, m, &now);
    }
    demi_pairs_changed(w);
    demi_built(w, __func__);
    return DEM_OK;
}

DEM_API dem_result dem_pair_get(const dem_world *world, dem_material a, dem_material b,
                                dem_pair *pair) {
    if (demi_null_look(world, __func__, pair, "pair")) return DEM_ERROR_ARGUMENT;
    dem_world *w = (dem_world *)world;          /* only the error message is written */
    int i = 0, j = 0;
    if (demi_material_index(w, __func__, a, &i) || demi_material_index(w, __func__, b, &j))
        return DEM_ERROR_ARGUMENT;
    *pair = w->pairs[i*DEMI_MATERIALS + j].given;
    return DEM_OK;
}

#define DEMI_COEF_PUT(PROPERTY, COEFFICIENT, UNIT) \
    out[DEMI_COEF_##COEFFICIENT] = (dem_real)k.COEFFICIENT;
/* Computes the coefficients of a contact of materials a and b: those of the normal law (>>laws) and
   those that all laws share. cn and ct lack the part that is proportional to sqrt(m*); root[0] (cn)
   and root[1] (ct) receive its factors, per sqrt(kg). r_eff: m, the standard R*; stiff: kg, the
   mass M of demi_scales; wall: 1 for a wall. DEM_CONVENTION_MILL follows the thesis [MIL]: E* = E
   of one body, 8 G of one body, half overlaps between grains (folded into the coefficients here),
   R/2 and m/2 against walls. Checked by "the eight coefficients". */
static void demi_coefficients_rooted(const dem_world *w, int a, int b, double r_eff, double stiff,
                                     int wall, dem_real *out, dem_real *root) {
    const dem_pair *p = &w->pairs[a*DEMI_MATERIALS + b].given;
    const int mill = w->desc.convention == DEM_CONVENTION_MILL;
    demi_scales s = {(double)p->young_eff, (double)p->shear_eff, r_eff, stiff, 0, 1, p};
    demi_coefs k;
    double half = 1;
    memset(&k, 0, sizeof k);
    s.beta = w->pairs[a*DEMI_MATERIALS + b].damping;
    if (w->desc.impact_speed > 0) s.speed = (double)w->desc.impact_speed;
    if (mill) {  /* moduli of the wall, or of the material of the two that was added first */
        const dem_material_desc *d = &w->materials[wall ? b : DEMI_MIN(a, b)];
        s.E = (double)d->young;
        s.G = s.E/(2*(1 + (double)d->poisson));
        if (wall) { s.R /= 2; s.M /= 2; half = sqrt(0.5); }
    }
    demi_normal_laws[w->desc.normal_law].coefs(&s, &k);
    if (mill && !wall && demi_normal_is(w, DEMI_HERTZIAN)) {   /* for half the overlap */
        const double fourth = demi_pow(0.5, 0.25);
        k.kn *= demi_pow(0.5, 1.5); k.kt *= sqrt(0.5);
        k.cn *= fourth; k.ct *= fourth; k.cn_root *= fourth; k.ct_root *= fourth;
    }
    k.ct *= (double)p->tangent_damping;
    k.ct_root *= (double)p->tangent_damping;
    out[DEMI_KN] = (dem_real)k.kn; out[DEMI_CN] = (dem_real)k.cn;
    out[DEMI_KT] = (dem_real)k.kt; out[DEMI_CT] = (dem_real)k.ct;
    out[DEMI_K_UN] = (dem_real)k.kun;
    DEM_LAW_COEFFICIENTS(DEMI_COEF_PUT)
    out[DEMI_MU] = p->friction;
    out[DEMI_MU_STATIC] = demi_static_friction(w, a, b);
    out[DEMI_MU_ROLL] = p->rolling_friction;
    out[DEMI_MU_SPIN] = p->spinning_friction;
    out[DEMI_R_EFF] = (dem_real)r_eff;
    root[0] = (dem_real)(half*k.cn_root);
    root[1] = (dem_real)(half*k.ct_root);
}
#define DEMI_COEF_USED(PROPERTY, COEFFICIENT, UNIT) used |= (k.COEFFICIENT > 0) << \
    DEMI_COEF_##COEFFICIENT;
/* Returns the bits of the coefficients, from DEMI_K_UN on, that the normal law in force uses: those
   that are not 0 if everything that they may depend on is 1. */
static int demi_law_own(const dem_world *w) {
    dem_pair p;
    const demi_scales s = {1, 1, 1, 1, 1, 1, &p};
    const dem_real one = 1;
    demi_coefs k;
    size_t i;
    int used;
    for (i = 0; i < sizeof p; i += sizeof one) memcpy((char *)&p + i, &one, sizeof one);
    memset(&k, 0, sizeof k);
    demi_normal_laws[w->desc.normal_law].coefs(&s, &k);
    used = (k.kun > 0) << DEMI_K_UN;
    DEM_LAW_COEFFICIENTS(DEMI_COEF_USED)
    return used;
}
/* The same with complete cn and ct. m_eff: kg, the standard m*. */
static void demi_coefficients(const dem_world *w, int a, int b, double r_eff, double m_eff,
                              double stiff, int wall, dem_real *out) {
    const dem_real m = (dem_real)sqrt(m_eff);
    dem_real root[2];
    demi_coefficients_rooted(w, a, b, r_eff, stiff, wall, out, root);
    out[DEMI_CN] += root[0]*m;
    out[DEMI_CT] += root[1]*m;
}

/* Returns the duration of a contact, s, at an impact speed (m/s). Hertz, undamped:
   2.94327518 delta_max/v. Linear: pi/sqrt(k/m - (c/2m)^2) [ALK07] eq 2.21, which is pi sqrt(m/k)
   without damping; near critical damping and above, where that diverges, pi 2m/c, the time constant
   of the dashpot. Hysteretic: the duration of the steepest branch, kun, which the time step must
   resolve; the contact itself lasts longer, eq 2.45. */
static double demi_contact_time(const dem_world *w, const dem_real *coef, double m_eff,
                                double speed) {
    const int branched = demi_normal_is(w, DEMI_BRANCHED);
    const double k = (double)coef[branched ? DEMI_K_UN : DEMI_KN], c = (double)coef[DEMI_CN];
    if (!demi_normal_is(w, DEMI_HERTZIAN)) {
        const double eta = c/(2*m_eff);
        return DEMI_PI/DEMI_MAX(sqrt(DEMI_MAX(k/m_eff - eta*eta, 0)), eta);
    }
    return 2.94327518*demi_pow(5*m_eff*speed*speed/(4*k), 0.4)/speed;
}

/* Mass, kg, and moment of inertia, kg m2, of a sphere, in planar worlds of a disc. */
static double demi_sphere_mass(const dem_world *w, int material, double r) {
    const double rho = (double)w->materials[material].density;
    if (w->desc.planar) return rho*DEMI_PI*r*r*(double)w->desc.thickness;
    return rho*4/3*DEMI_PI*r*r*r;
}
static double demi_sphere_inertia(const dem_world *w, double mass, double r) {
    return w->desc.planar ? mass*r*r/2 : 0.4*mass*r*r;
}

#define DEMI_COEF_GET(PROPERTY, COEFFICIENT, UNIT) out->COEFFICIENT = coef[DEMI_COEF_##COEFFICIENT];
DEM_API dem_result dem_coefficients_get(const dem_world *world, dem_material a, dem_material b,
                                        dem_real radius_a, dem_real radius_b,
                                        dem_coefficients *out) {
    if (demi_null_look(world, __func__, out, "out")) return DEM_ERROR_ARGUMENT;
    dem_world *w = (dem_world *)world;
    int i = 0, j = 0;
    double ra = (double)radius_a, rb = (double)radius_b, ma, r, m;
    dem_real coef[DEMI_COEFS];
    if (demi_material_index(w, __func__, a, &i) || demi_material_index(w, __func__, b, &j))
        return DEM_ERROR_ARGUMENT;
    if (!(ra > 0) || !(rb >= 0) || !demi_finite(radius_a) || !demi_finite(radius_b))
        return demi_refuse(w, __func__, "radii are %g and %g m; the first must be > "
                           "0, the second >= 0 (0 means a wall)", ra, rb);
    ma = demi_sphere_mass(w, i, ra);
    r = rb > 0 ? ra*rb/(ra + rb) : ra;
    m = rb > 0 ? 1/(1/ma + 1/demi_sphere_mass(w, j, rb)) : ma;
    demi_coefficients(w, i, j, r, m, m, rb <= 0, coef);
    out->r_eff = (dem_real)r; out->m_eff = (dem_real)m;
    out->kn = coef[DEMI_KN]; out->cn = coef[DEMI_CN]; out->kt = coef[DEMI_KT];
    out->ct = coef[DEMI_CT];
    out->kun = coef[DEMI_K_UN];
    DEM_LAW_COEFFICIENTS(DEMI_COEF_GET)
    out->damping_ratio = (dem_real)w->pairs[i*DEMI_MATERIALS + j].damping;
    out->contact_time = (dem_real)demi_contact_time(w, coef, m, w->desc.impact_speed > 0
                                                    ? (double)w->desc.impact_speed : 1);
    if (demi_normal_is(w, DEMI_BRANCHED))
        out->contact_time = (dem_real)(DEMI_PI/2*(sqrt(m/(double)out->kn) +
                                                  sqrt(m/(double)out->kun)));
    return DEM_OK;
}

/* A column for a coefficient of a single law that some pair has. */
#define DEMI_PROPERTY_HEAD(PROPERTY, COEFFICIENT, UNIT) \
    if (demi_pairs_have(w, offsetof(dem_pair, PROPERTY))) \
        demi_print(out, "  " #PROPERTY " [" UNIT "]");
#define DEMI_PROPERTY_PRINT(PROPERTY, COEFFICIENT, UNIT) \
    if (demi_pairs_have(w, offsetof(dem_pair, PROPERTY))) \
        demi_print(out, "  %-*.4g", (int)sizeof #PROPERTY " [" UNIT "]" - 1, (double)p->PROPERTY);
static int demi_pairs_have(const dem_world *w, size_t offset) {
    const int n = w->material_count;
    dem_real x = 0;
    int k;
    for (k = 0; k < n*n && !(x > 0); k++)
        memcpy(&x, (const char *)&w->pairs[k/n*DEMI_MATERIALS + k%n].given + offset, sizeof x);
    return x > 0;
}
DEM_API void dem_pairs_print(const dem_world *w, FILE *out) {
    if (demi_null_look(w, __func__, out, "out")) return;
    const int laws = demi_response_is(w, DEMI_LAWS);
    int i, j;
    demi_print(out, "pair       E* [Pa]      G* [Pa]      e      mu     mu_s   mu_r   k [N/m]    "
               "kt/kn%s", laws ? "" : "  mu_spin cohesion [N] compliance [m/N]");
    DEM_LAW_COEFFICIENTS(DEMI_PROPERTY_HEAD)
    demi_print(out, "\n");
    for (i = 0; i < w->material_count; i++)
        for (j = i; j < w->material_count; j++) {
            const dem_pair *p = &w->pairs[i*DEMI_MATERIALS + j].given;
            demi_print(out, "%2d - %-2d  %12.6g %12.6g  %-6.4g %-6.4g %-6.4g %-6.4g %-10.4g %-6.4g",
                    i + 1, j + 1, (double)p->young_eff, (double)p->shear_eff,
                    (double)p->restitution, (double)p->friction,
                    (double)DEMI_MAX(p->friction, p->friction_static), (double)p->rolling_friction,
                    (double)p->stiffness, (double)p->stiffness_ratio);
            if (!laws)
                demi_print(out, " %-7.4g %-12.4g %.4g", (double)p->spinning_friction,
                           (double)p->cohesion, (double)p->compliance);
            DEM_LAW_COEFFICIENTS(DEMI_PROPERTY_PRINT)
            demi_print(out, "%s\n", p->ignored ? "  ignored" : "");
        }
}
