/* ---------------------------------------------------------------------------------------------
   >>world
   Creating a world and destroying it. dem_world_create checks the desc. Fields that are 0 are
   replaced by a choice, there or when a run begins. Every block that a world allocates (demi_hold)
   is linked into one of two chains; dem_world_destroy frees both, so no array can be forgotten.
   --------------------------------------------------------------------------------------------- */
DEM_API const char *dem_result_name_get(dem_result r) {
    static const char *names[] = {"ok", "bad argument", "out of memory", "file error",
                                  "bad format", "time step too large",
                                  "unstable", "stopped"};
    return (int)r >= 0 && (size_t)r < sizeof names/sizeof *names ? names[r] : "unknown";
}

DEM_API const char *dem_world_create_error_get(const dem_world_desc *d) {
    if (!d) return "dem_world_create: desc is null; give the address of a dem_world_desc that "
        "began as DEM_WORLD_DESC";
    const dem_real lo[3] = {d->domain.lo.x, d->domain.lo.y, d->domain.lo.z};
    const dem_real hi[3] = {d->domain.hi.x, d->domain.hi.y, d->domain.hi.z};
    int k;
    const demi_field_row *bad = demi_rows_bad(0, demi_world_desc_rows, d, &k);
    if (bad) return bad->refusal;
    if (!demi_law_known(demi_normal_laws, (int)d->normal_law) ||
        !demi_law_known(demi_tangent_laws, (int)d->tangent_law) ||
        !demi_law_known(demi_rolling_laws, (int)d->rolling_law))
        return "dem_world_create: a contact law is not one of the enum values; start from "
            "DEM_WORLD_DESC";
    if ((int)d->integrator < 0 || (int)d->integrator >= DEMI_INTEGRATORS || (int)d->search < 0 ||
        (int)d->search >= DEMI_SEARCHES || (int)d->cone < 0 || d->cone > DEM_CONE_CONVEX ||
        (int)d->solver < 0 || d->solver > DEM_SOLVER_SPECTRAL)
        return "dem_world_create: integrator, search, cone or solver is not one of the enum "
            "values; start from DEM_WORLD_DESC";
    for (k = 0; k < 3; k++)
        if (d->boundary[k] != DEM_BOUNDARY_OPEN &&
            (!(hi[k] > lo[k]) || !demi_bounded((double)lo[k]) || !demi_bounded((double)hi[k])))
            return "dem_world_create: a boundary is periodic or outflow, but domain.lo is not "
                "below domain.hi there, or one is beyond 1e15 m; set domain";
    if (d->planar && d->boundary[2] != DEM_BOUNDARY_OPEN)
        return "dem_world_create: planar is 1, but the z boundary is not open; discs stay at z "
            "= 0: leave it open";
    if (demi_dt_bad(d->dt)) return "dem_world_create: dt must be 0 or 1e-20 to 1e15 s; 0 lets the "
        "library choose";
    if (!d->law && ((d->law_range > 0 && d->response != DEM_RESPONSE_IMPULSES) ||
                    d->law_range_radii > 0 || d->law_who || d->law_rows))
        return "dem_world_create: law_range, law_range_radii, law_who or law_rows is set, but law "
            "is null; they apply only to a user-defined law: set law, or leave them 0";
    if (d->law_rate && (!d->law || !d->law_who || !d->body_reals))
        return "dem_world_create: law_rate is set without law, law_who or body_reals; it gives "
            "the rate at which your law changes the numbers of bodies: set all four, or leave it "
            "null";
#ifdef DEM_NO_IMPULSES
    if (d->response == DEM_RESPONSE_IMPULSES)
        return "dem_world_create: response is DEM_RESPONSE_IMPULSES, but dem.h was compiled with "
            "DEM_NO_IMPULSES; compile it without that switch, or use springs";
#endif
    if (d->response == DEM_RESPONSE_IMPULSES && !(d->dt > 0))
        return "dem_world_create: response is DEM_RESPONSE_IMPULSES, but dt is 0 s; impulses have "
            "no contact time to choose it from: set a dt in which grains move by less than a "
            "tenth of their radius, such as 1e-3 s";
    if (d->response == DEM_RESPONSE_IMPULSES &&
        (d->law || (d->integrator != DEM_INTEGRATOR_VELOCITY_VERLET &&
                    d->integrator != DEM_INTEGRATOR_SYMPLECTIC_EULER)))
        return "dem_world_create: response is DEM_RESPONSE_IMPULSES, but law or integrator is "
            "set; impulses use neither: leave both 0";
    if (demi_names(d->body_reals, DEM_BODY_REALS) < 0)
        return "dem_world_create: body_reals must be at most 8 words of at most 23 letters, "
            "digits and _, separated by one space, such as \"temperature charge\"; null means none";
    if (demi_names(d->groups, DEM_GROUPS) < 0)
        return "dem_world_create: groups must be at most 32 words of at most 23 letters, digits "
            "and _, separated by one space, such as \"coarse tracer\"; null means none";
    if (demi_names(d->law_memory_names, d->law_memory) < 0)
        return "dem_world_create: law_memory_names must be at most law_memory words of at most 23 "
            "letters, digits and _, separated by one space; null means memory0, memory1, ...";
    if (!demi_names(d->body_reals, DEM_BODY_REALS) && d->body_reals_fn)
        return "dem_world_create: body_reals_fn is given, but body_reals names no numbers; name "
            "them, or leave both 0";
#ifdef __TINYC__
    if (DEMI_SINGLE) return "dem_world_create: tcc 0.9.27 computes some float expressions "
        "wrongly; compile with gcc or clang, or leave DEM_REAL at double";
#endif
    if (d->law_vectors < 0 || d->law_vectors > d->law_memory/3)
        return "dem_world_create: law_vectors must be 0 to law_memory/3; increase law_memory, "
            "which counts reals";
    if (!d->allocator.alloc_fn != !d->allocator.free_fn)
        return "dem_world_create: the allocator has only one of alloc_fn and free_fn; give both "
            "or neither";
    return "";
}

DEM_API dem_world *dem_world_create_checked(const dem_world_desc *desc, int version,
                                            size_t real_size) {
    dem_world *w;
    if (version != DEM_VERSION || real_size != sizeof(dem_real) ||
        *dem_world_create_error_get(desc)) return 0;
    w = (dem_world *)demi_raw_alloc(0, &desc->allocator, sizeof *w);
    if (!w) return 0;
    memset(w, 0, sizeof *w);
    w->desc = w->asked = *desc;
    demi_names_own(w, desc);
    w->bytes = sizeof *w;
    if (!(w->desc.thickness > 0)) w->desc.thickness = 1;
    if (w->desc.planar) w->desc.gravity.z = 0;
    if (demi_response_is(w, DEMI_MIDWAY)) w->desc.integrator = DEM_INTEGRATOR_SYMPLECTIC_EULER;
    /* until there are bodies, by which demi_levels_choose decides */
    if (w->desc.search == DEM_SEARCH_AUTO) w->desc.search = DEM_SEARCH_GRID;
    if (w->desc.threads == 0) w->desc.threads = DEMI_MIN(demi_threads_available(), 64);
    w->threads.now = w->desc.threads;              /* until the first step */
    w->threads.fixed = DEMI_THREADS_FIXED;
    demi_bodies_begin(w);
    w->bodies.orienting = desc->orientations != 0;
    w->bodies.backward = demi_integrator_of(w)->backward;
    w->bodies.booked = desc->ledger && demi_integrator_of(w)->predicts;
    w->pairs = (demi_pair *)demi_hold(w, DEMI_SCENE, (size_t)DEMI_MATERIALS*DEMI_MATERIALS,
                                      sizeof(demi_pair));
    w->domains = (demi_domain *)demi_hold(w, DEMI_RUN, DEMI_DOMAINS, sizeof(demi_domain));
    w->cross_incoming_start = (int *)demi_hold(w, DEMI_RUN, DEMI_DOMAINS + 1, sizeof(int));
    if (!w->pairs || !w->domains || !w->cross_incoming_start) {
        dem_world_destroy(w);
        return 0;
    }
    return w;
}

DEM_API void dem_world_destroy(dem_world *w) {
    dem_allocator allocator;
    int chain;
    if (demi_null(w, __func__, w, "world")) return;
    if (w->look.under_way) {
        demi_refuse(w, __func__, "called from the function of an output "
                    "(dem_output_add) while the world runs; return 1 from that function to stop "
                    "the run, then destroy the world");
        return;
    }
    demi_calls(w, __func__, 1);                 /* the allocator sees an incomplete world */
    for (chain = 0; chain < DEMI_CHAINS; chain++) demi_free_chain(w, chain);
    allocator = w->desc.allocator;
    demi_raw_free(0, &allocator, w, sizeof *w);
}

DEM_API const char *dem_world_error_get(const dem_world *w) {
    if (!w) return "dem_world_create: the world is null, because dem_world_create failed; "
        "dem_world_create_error_get(desc) says why";
    ((dem_world *)w)->refused = 0;              /* the message has been read */
    return w->error;
}
