/* ---------------------------------------------------------------------------------------------
   >>law-rows
   User-defined laws that take a row of contacts at once. With a law that dem.h calls contact by
   contact (dem_law_fn), a step of a bed takes about 3 times as long as with a built-in law.
   DEM_LAW_ROWS turns the same law into a loop over columns, which compilers vectorise; a step then
   takes about 1.25 times as long:

       DEM_INLINE void sticky(const dem_contact *c, dem_real *memory, dem_contact_force *force) {
           (void)memory;
           force->normal = 1e4*c->overlap + 3*c->closing_speed - 0.02;   // N
       }
       DEM_LAW_ROWS(sticky_rows, sticky, 0)             // 0 reals of contact history

       desc.law = sticky;
       desc.law_rows = sticky_rows;
   --------------------------------------------------------------------------------------------- */

#if defined(__clang__)
#define DEMI_VECTOR              /* clang checks for aliases at run time and warns about ivdep */
#elif defined(__GNUC__) && !defined(__TINYC__)
#define DEMI_VECTOR _Pragma("GCC ivdep")
#else
#define DEMI_VECTOR
#endif
/* Expands DO(0) to DO(7). Compilers do not unroll such a loop at -O2. */
#define DEMI_EIGHT(DO) do { DO(0); DO(1); DO(2); DO(3); DO(4); DO(5); DO(6); DO(7); } while (0)

/* Marks a kernel that is compiled twice, for the baseline processor and for AVX2. The loader
   chooses between them. Only where this needs no action from the user. "avx2" does not enable fused
   multiply-add, so both versions give the same bits. */
#if defined(__GNUC__) && !defined(__clang__) && defined(__GLIBC__) && defined(__x86_64__) && \
    !defined(__AVX2__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && \
    !defined(DEM_NO_CLONES)
#define DEMI_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define DEMI_CLONES
#endif

#define DEM_ROW_GROUP (64/(int)sizeof(dem_real))      /* contacts of a vector group */

#define DEMI_ROW_FIELD(PROPERTY, COEFFICIENT, UNIT) const dem_real *COEFFICIENT;
/* A row of contacts in columns: c->overlap[q] is the overlap of contact q, c->normal[1][q] the y of
   its normal. The fields and their units are those of dem_contact, then those of dem_contact_force,
   which the law must set for every q below `count`. Some contacts of a row are not in touch, and
   the last group is padded: dem.h ignores what the law returns for these, and clears their
   history. */
typedef struct dem_contact_rows {
    int count;                     /* a multiple of DEM_ROW_GROUP */
    int memory_count;              /* desc.law_memory */
    const dem_real *touch;         /* 1 in contact or within the range of the law, otherwise 0 */
    const dem_real *overlap, *range, *closing_speed, *twist, *sliding;
    const dem_real *normal[3], *slip[3], *spin[3], *slip_step[3], *spin_step[3], *normal_rate[3];
    const dem_real *r_eff, *m_eff, *kn, *cn, *kt, *ct, *kun;
    const dem_real *friction, *friction_static, *rolling_friction, *spinning_friction;
    const int32_t *material_a, *material_b;
    DEM_LAW_COEFFICIENTS(DEMI_ROW_FIELD)
    dem_real dt;                   /* s; this and the following are the same for all contacts */
    int tension, friction_load, slider;
    void *user;
    dem_real *memory[DEM_LAW_MEMORY];             /* contact history: memory[k][q] */
    dem_real *normal_force, *tangent[3], *moment[3], *slides;     /* slides: force->sliding */
    /* in the order of dem_contact_energy; all null if the world keeps no ledger */
    dem_real *energy[7];
} dem_contact_rows;
#undef DEMI_ROW_FIELD

/* A law that computes the forces of a row of contacts: see dem_world_desc.law_rows. */
typedef void (*dem_law_rows_fn)(const dem_contact_rows *rows);

#define DEMI_ROW_COEFFICIENT(PROPERTY, COEFFICIENT, UNIT) c.COEFFICIENT = rows->COEFFICIENT[q];
#define DEMI_ROW_VECTOR(v) dem_vec3_make(rows->v[0][q], rows->v[1][q], rows->v[2][q])
#define DEMI_ROW_RECALL(e) m[e] = (e) < count ? rows->memory[e][q] : 0
#define DEMI_ROW_KEEP(e) if ((e) < count) rows->memory[e][q] = touch ? m[e] : 0
/* Evaluates `law` for contact q of a row. count: its reals of history. touch: is the contact in
   touch? */
DEM_INLINE void demi_law_of_row(const dem_contact_rows *rows, int q, int touch, dem_law_fn law,
                                int count, int ledger) {
    dem_contact c = DEM_ZERO;
    dem_contact_force f = DEM_ZERO;
    dem_real m[DEM_LAW_MEMORY];
    int e;
    c.overlap = rows->overlap[q]; c.range = rows->range[q];
    c.closing_speed = rows->closing_speed[q]; c.twist = rows->twist[q];
    c.sliding = rows->sliding[q];
    c.normal = DEMI_ROW_VECTOR(normal); c.normal_rate = DEMI_ROW_VECTOR(normal_rate);
    c.slip = DEMI_ROW_VECTOR(slip); c.slip_step = DEMI_ROW_VECTOR(slip_step);
    c.spin = DEMI_ROW_VECTOR(spin); c.spin_step = DEMI_ROW_VECTOR(spin_step);
    c.r_eff = rows->r_eff[q]; c.m_eff = rows->m_eff[q];
    c.kn = rows->kn[q]; c.cn = rows->cn[q]; c.kt = rows->kt[q]; c.ct = rows->ct[q];
    c.kun = rows->kun[q];
    c.friction = rows->friction[q]; c.friction_static = rows->friction_static[q];
    c.rolling_friction = rows->rolling_friction[q];
    c.spinning_friction = rows->spinning_friction[q];
    c.material_a = rows->material_a[q]; c.material_b = rows->material_b[q];
    DEM_LAW_COEFFICIENTS(DEMI_ROW_COEFFICIENT)
    c.dt = rows->dt; c.tension = rows->tension; c.friction_load = rows->friction_load;
    c.slider = rows->slider; c.user = rows->user;
    DEMI_EIGHT(DEMI_ROW_RECALL);
    for (e = 8; e < count; e++) m[e] = rows->memory[e][q];
    law(&c, m, &f);
    DEMI_EIGHT(DEMI_ROW_KEEP);
    for (e = 8; e < count; e++) rows->memory[e][q] = touch ? m[e] : 0;
    rows->normal_force[q] = touch ? f.normal : 0;
    rows->tangent[0][q] = touch ? f.tangent.x : 0;
    rows->tangent[1][q] = touch ? f.tangent.y : 0;
    rows->tangent[2][q] = touch ? f.tangent.z : 0;
    rows->moment[0][q] = touch ? f.moment.x : 0;
    rows->moment[1][q] = touch ? f.moment.y : 0;
    rows->moment[2][q] = touch ? f.moment.z : 0;
    rows->slides[q] = touch ? f.sliding : 0;
    if (!ledger) return;
    rows->energy[0][q] = touch ? f.energy.dashpot : 0;
    rows->energy[1][q] = touch ? f.energy.sag : 0;
    rows->energy[2][q] = touch ? f.energy.elastic : 0;
    rows->energy[3][q] = touch ? f.energy.shear_work : 0;
    rows->energy[4][q] = touch ? f.energy.slide : 0;
    rows->energy[5][q] = touch ? f.energy.shear_stored : 0;
    rows->energy[6][q] = touch ? f.energy.roll : 0;
}
#undef DEMI_ROW_COEFFICIENT
#undef DEMI_ROW_VECTOR
#undef DEMI_ROW_RECALL
#undef DEMI_ROW_KEEP
#if defined(__GNUC__) && !defined(__clang__) && !defined(__TINYC__)
#define DEMI_QUIET __attribute__((optimize("no-trapping-math", "no-math-errno", "fp-contract=off")))
#else
#define DEMI_QUIET
#endif
#define DEMI_LAW_ROWS(LAW, MEMORY, LEDGER) \
    for (g = 0; g < rows->count; g += DEM_ROW_GROUP) \
        DEMI_VECTOR \
        for (l = g; l < g + DEM_ROW_GROUP; l++) \
            demi_law_of_row(rows, l, rows->touch[l] > 0, LAW, MEMORY, LEDGER);
/* Defines the function NAME, a dem_law_rows_fn, from the law LAW, a DEM_INLINE function with
   MEMORY reals of contact history (0 to 16, a constant equal to desc.law_memory). */
#define DEM_LAW_ROWS(NAME, LAW, MEMORY) \
    DEMI_QUIET \
    DEMI_CLONES static void NAME(const dem_contact_rows *all) { \
        const dem_contact_rows c = *all, *rows = &c;     /* in registers: nothing overlaps it */ \
        int g, l; \
        if (rows->energy[0]) { DEMI_LAW_ROWS(LAW, MEMORY, 1) } \
        else { DEMI_LAW_ROWS(LAW, MEMORY, 0) } \
    }
