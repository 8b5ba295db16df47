/* ---------------------------------------------------------------------------------------------
   >>report
   Reports on a world: the choices that replaced fields that were 0, the effects in use, what
   happened. It calls the same functions as a run, but on a copy of struct dem_world, so a report
   changes nothing that a run uses.
   --------------------------------------------------------------------------------------------- */
/* Prints why a chosen dt is shorter than t_c/50, and by what factor. */
static void demi_held_report(const dem_world *w, FILE *out) {
    const demi_held *h = &w->clock.held;
    char who[64] = "a body";
    if (w->desc.dt > 0 || h->by == DEMI_HELD_NOT || !(w->clock.dt > 0)) return;
    demi_print(out, "           dt is %.3g times shorter than t_c/50 = %.4g s: ",
               h->from/(double)w->clock.dt, h->from);
    if (h->body > 0)
        demi_words(who, sizeof who, "body %d, pressed by %.3g contacts,", (int)h->body,
                   h->contacts);
    if (h->by == DEMI_HELD_PRESSED)
        demi_print(out, "%s is stable to %.4g s, and half of that is used\n", who, h->limit);
    else if (h->by == DEMI_HELD_RATE)
        demi_print(out, "the numbers of body %d (desc.law_rate) are stable to %.4g s, and half of "
                   "that is used\n", (int)h->body, h->limit);
    else if (h->by == DEMI_HELD_SPIN)
        demi_print(out, "a body that is not a sphere spins at %.3g rad/s\n", h->limit);
    else demi_print(out, "dashpot, friction or rolling is stable to %.4g s, and a fifth of that is "
                    "used\n", h->limit);
}
/* Prints the levels of a hierarchical grid, and the estimated work of a search with levels and
   with one grid. */
static void demi_levels_report(const dem_world *w, FILE *out) {
    const int auto_ = w->asked.search == DEM_SEARCH_AUTO;
    int i;
    if (w->desc.search == DEM_SEARCH_HIERARCHICAL && w->levels.count) {
        demi_print(out, "           %d level%s for radii 1 : %.3g, of up to", w->levels.count,
                   w->levels.count == 1 ? "" : "s",
                   (double)w->effects.radius_max/DEMI_MAX((double)w->effects.radius_min, 1e-300));
        for (i = 0; i < w->levels.count; i++)
            demi_print(out, "%s %.3g m (%d)", i ? "," : "", w->levels.level[i].radius,
                       w->levels.level[i].count);
        demi_print(out, "\n");
    }
    if (w->levels.tests[0] > 0)
        demi_print(out, "           %s: %s; distance tests per body and search, estimated: %.3g "
                   "with levels, %.3g with one grid\n", auto_ ? "chosen" : "set",
                   demi_searches[w->desc.search].name, w->levels.tests[1], w->levels.tests[0]);
}

/* Returns the number of persistent contacts. */
static int demi_persistent_total(const dem_world *w) {
    int d, n = 0;
    for (d = 0; d < w->domain_count; d++) n += w->domains[d].persistent;
    return n;
}
/* Returns in `text` how much contact history a law keeps, or "" if none. */
static const char *demi_law_memory_text(const demi_law_row *row, char text[64]) {
    text[0] = 0;
    if (row->memory)
        demi_words(text, 64, " (%d bytes of memory per neighbour pair)",
                   row->memory*(int)sizeof(dem_real));
    return text;
}
/* Prints the contact laws in force. Of a user-defined law only its settings are known. */
static void demi_laws_report(const dem_world *w, FILE *out) {
    static const char *loads[] = {"the normal force", "the elastic part of the normal force",
                                  "the magnitude of the normal force"};
    static const char *sliders[] = {"spring and dashpot share this limit",
                                    "the spring alone takes this limit",
                                    "the spring takes what the dashpot leaves"};
    const int load = w->desc.tension != DEM_TENSION_ALLOWED ? DEM_LOAD_REPULSIVE
        : (int)w->desc.friction_load;           /* without tension: the normal force */
    const demi_laws *laws = &w->laws;
    char text[64];
    int i;
    const char *unused = "", *lacks;
#ifdef DEM_LAW
    unused = "; DEM_LAW is named, but desc.law is null, so it does not act here";
#endif
    if (!demi_response_is(w, DEMI_LAWS)) {
        demi_print(out, "effects    contacts are impulses, %s; gaps up to %.3g m are "
                "included\n           last step: %d sweeps left %.3g m/s; %llu steps did not reach "
                "their tolerance", w->desc.cone == DEM_CONE_CONVEX ? "convex law" : "Coulomb's law",
                demi_foreseen(w), w->booked.sweeps, w->booked.residual,
                (unsigned long long)w->booked.unsolved);
        if (w->solver.limited)
            demi_print(out, "; in the last of them %d contacts were at their friction limit",
                       w->solver.limited);
        fputc('\n', out);
        return;
    }
    if (w->desc.law) {
        demi_print(out, "effects    normal, tangential, rolling: user-defined law; spins and "
                   "torques are followed; %d reals of memory per contact\n", w->desc.law_memory);
        for (i = 0; i < w->material_count; i++)
            if ((lacks = demi_law_lacks(w, i)) != 0)
                demi_print(out, "           it exerts no moment against the %s of material %d\n",
                           lacks, i + 1);
        if (w->margin.reach > 0)
            demi_print(out, "           called for gaps below %.3g m, in contact or not\n",
                       w->margin.reach);
#ifdef DEM_LAW
        if (w->desc.law != DEM_LAW)
            demi_print(out, "           DEM_LAW names another law than desc.law\n");
#endif
        demi_print(out, "           %s\n", demi_own_rows(w) ? "contacts of spheres row by row"
                   : w->desc.law_who ? "called contact by contact, because law_who is set: slower"
                   : "called contact by contact: slower; DEM_LAW_ROWS makes a law for rows of it");
        return;
    }
    demi_print(out, "effects    normal: %s%s%s%s\n", laws->normal->name,
               w->desc.tension == DEM_TENSION_CLIPPED ? ", tension clipped"
               : w->desc.tension == DEM_TENSION_COMPENSATED ? ", no tension" : "",
               demi_law_memory_text(laws->normal, text), unused);
    demi_print(out, "           tangential: %s%s\n", laws->tangent->name, laws->tangent->law
               ? demi_law_memory_text(laws->tangent, text)
               : " (no friction in any pair: no spin, no torque, no memory)");
    if (laws->tangent->law)
        demi_print(out, "           friction is limited to mu times %s; %s\n", loads[load],
                   laws->tangent->memory ? sliders[w->desc.slider] : "there is only a dashpot");
    demi_print(out, "           rolling: %s%s\n", laws->rolling->name,
               demi_law_memory_text(laws->rolling, text));
}
/* Prints the options of the desc that were set and that no other line prints. */
static void demi_options_report(const dem_world *w, FILE *out) {
    const demi_field_row *r;
    char value[DEMI_ROW_MOST], text[48];
    int count = 0;
    for (r = demi_world_desc_rows; r->name; r++) {
        if (!(r->how & DEMI_PRINTED) || !(fabs(demi_row_read(r, &w->asked, 0)) > 0)) continue;
        demi_row_value(r, &w->asked, value);
        demi_row_print(r, value, 0, 6, text, sizeof text);
        demi_print(out, "%s%s %s", count++ ? ", " : "options    ", r->name, text);
    }
    if (count) fputc('\n', out);
}
/* Prints a line about bodies that are not spheres, or about orientations of spheres, if there are
   any. */
static void demi_shapes_report(const dem_world *w, FILE *out) {
    static const char *overlaps[] = {"conservative", "[RUB15]'s chord", "along the normal"};
    if (w->bodies.shaped && !w->effects.unlike)
        demi_print(out, "           %d bodies are clusters of one sphere, computed as spheres: "
                   "rotation by %s\n", w->bodies.shaped, demi_rotation_rows[w->desc.rotation].name);
    else if (w->bodies.shaped)
        demi_print(out, "           %d bodies are not spheres: rotation by %s; overlap of "
                "ellipsoids %s; contacts of a cluster %s; %.2f contacts per body\n",
                w->bodies.shaped,
                demi_rotation_rows[w->desc.rotation].name, overlaps[w->desc.ellipsoid_overlap],
                w->desc.cluster_contacts == DEM_CLUSTER_CONTACTS_MERGED ? "are merged"
                : "are separate", w->bodies.count ? (double)demi_persistent_total(w)/w->bodies.count
                   : 0);
    else if (w->bodies.orienting)
        demi_print(out, "           orientations of spheres are followed, because "
                   "desc.orientations is 1\n");
}
/* Prints the loads of walls and joints, and the flows of feeds and outlets. */
static void demi_flows_report(const dem_world *w, FILE *out) {
    int i;
    for (i = 0; i < w->wall_count; i++) {
        const dem_wall_loads *ch = &w->walls[i].loads;
        if (w->walls[i].kind == DEMI_WALL_NONE) continue;
        demi_print(out, "wall %-3d   %d contacts, force (%.4g, %.4g, %.4g) N, axial torque %.4g N "
                   "m, power %.4g W\n", (int)w->walls[i].id, ch->contacts, (double)ch->force.x,
                   (double)ch->force.y, (double)ch->force.z, (double)ch->torque_axial,
                   (double)ch->power);
    }
    for (i = 0; i < w->wall_count; i++) {
        const dem_motion *m = &w->walls[i].motion;
        dem_servo s;
        if (w->walls[i].kind == DEMI_WALL_NONE || m->kind != DEM_MOTION_SERVO) continue;
        s = demi_servo_now(w, i);
        demi_print(out, "servo %-3d  presses along (%.3g, %.3g, %.3g) m/s with %.6g N, target %.6g "
                "N, error %.3g N; speed %.4g m/s, %.6g m from its start%s\n", (int)w->walls[i].id,
                (double)m->velocity.x, (double)m->velocity.y, (double)m->velocity.z, s.force,
                s.target, s.force - s.target, s.speed, s.travel, m->travel > 0 &&
                fabs(s.travel) >= (double)m->travel*(1 - 1e-6) ? ", the limit of its travel" : "");
    }
    if (w->cell.on)
        demi_print(out, "cell       strain %.4g %.4g %.4g, shear %.4g; rates %.4g %.4g %.4g, "
                   "%.4g 1/s; stress %.6g %.6g %.6g Pa\n", w->cell.strain[0], w->cell.strain[1],
                   w->cell.strain[2], w->cell.sheared, w->cell.rate[0], w->cell.rate[1],
                   w->cell.rate[2], w->cell.shear, w->cell.stress[0], w->cell.stress[1],
                   w->cell.stress[2]);
#ifndef DEM_NO_IMPULSES
    for (i = 0; i < w->joint_count; i++) {
        const dem_joint_state *j = &w->joints[i].state;
        if (!demi_joint_alive(w, w->joints + i)) continue;
        demi_print(out, "joint %-3d  force %.4g N, torque %.4g N m; motor %.4g N m, %.4g W; gap "
                   "%.3g m\n", (int)w->joints[i].id, (double)demi_length(j->force),
                   (double)demi_length(j->torque), (double)j->motor_torque, (double)j->power,
                   (double)j->gap);
    }
#endif
    for (i = 0; i < w->feed_count; i++) {
        const dem_feed_state *f = &demi_feed_at(w, i)->state;
        demi_print(out, "feed %-3d   %llu grains, %.6g kg; %llu wait for room%s\n", i + 1,
                   (unsigned long long)f->total, f->mass, (unsigned long long)f->waiting,
                   f->done ? "; done" : "");
    }
    for (i = 0; i < w->outlet_count; i++) {
        const dem_outlet_state *o = &demi_outlet_at(w, i)->state;
        const dem_outlet_desc *of = &demi_outlet_at(w, i)->desc;
        demi_print(out, "outlet %-3d %llu grains, %.6g kg%s", i + 1, (unsigned long long)o->total,
                   o->total_mass, demi_outlet_at(w, i)->zone < 0 ? "" : " came in and stayed");
        if (of->wanted_min > 0 || of->wanted_max > 0)
            demi_print(out, ", of them wanted %llu, %.6g kg", (unsigned long long)o->sorted,
                       o->sorted_mass);
        fputc('\n', out);
    }
}
/* Prints the account of energy. A large residual means that the time step is too large. */
static void demi_ledger_report(const dem_world *w, FILE *out) {
    const dem_ledger l = dem_ledger_get(w);
    demi_print(out, "ledger [J] in: gravity %.6g, walls %.6g, field %.6g, inserted %.6g, removed "
            "%.6g\n           stored: kinetic %.6g, rotational %.6g, elastic %.6g\n"
            "           lost: normal %.6g, sliding %.6g, tangential %.6g, rolling %.6g\n",
            l.gravity, l.walls, l.force, l.inserted, l.removed, l.kinetic, l.rotational, l.elastic,
            l.normal, l.slide, l.tangent, l.rolling);
    if (l.growth < 0 || l.growth > 0)
        demi_print(out, "           in by growing radii and changes of the scene: %.6g\n",
                   l.growth);
    if (w->desc.law && !(w->booked.energy[DEMI_E_TOLD] > 0))
        demi_print(out, "           unknown to the ledger: %.3g J of your law, which does not set "
                   "force->energy\n", l.unknown);
    else
        demi_print(out, "           residual %.3g (%.2g of the throughput)\n", l.residual,
                   l.throughput > 0 ? l.residual/l.throughput : 0);
}
/* Prints effects that the scene contains and that have not happened so far. */
static void demi_idle_report(dem_world *look, FILE *out) {
    dem_effect e[DEM_EFFECTS];
    int k;
    demi_effects_look(look, e);
    for (k = 0; k < DEM_EFFECTS; k++)
        if (e[k].missing)
            demi_print(out, "           %s: %s\n", e[k].name, e[k].text);
}
/* Prints the report; section 11 of the manual explains its lines. */
static void demi_report(const dem_world *world, FILE *out) {
    dem_world look = *world, *w = &look;        /* computes missing effects in a copy */
    const dem_counters c = dem_counters_get(w);
    const double per = w->bodies.count ? 1.0/w->bodies.count : 0;
    char few[48] = "", crushed[128];
    dem_advice a;
    int i, walls = 0;
    for (i = 0; i < w->wall_count; i++) walls += w->walls[i].kind != DEMI_WALL_NONE;
    if (!w->stage.list_valid) { demi_effects(w); demi_levels_choose(w); }
    demi_advise(w, &a);
    if (w->threads.best && w->threads.best < c.threads)
        demi_words(few, sizeof few, " (%d in use: more were not faster)", w->threads.best);
    demi_print(out, "dem.h %d.%d.%d, %s precision, %d thread%s%s, %d domain%s, %.1f MB\n",
            DEM_VERSION_MAJOR, DEM_VERSION_MINOR, DEM_VERSION_PATCH,
            DEMI_SINGLE ? "single" : "double", c.threads, c.threads == 1 ? "" : "s", few, c.domains,
            c.domains == 1 ? "" : "s", (double)c.memory/1e6);
    demi_print(out, "bodies     %d of radius %g to %g m; %llu inserted = %llu present + %llu "
               "removed + %llu left\n", w->bodies.count, (double)w->effects.radius_min,
               (double)w->effects.radius_max, (unsigned long long)w->bodies.balance.inserted,
               (unsigned long long)w->bodies.balance.present,
               (unsigned long long)w->bodies.balance.removed,
               (unsigned long long)w->bodies.balance.left);
    demi_print(out, "time       %g s in %llu steps of %g s by %s (order %d)\n", w->clock.time,
               (unsigned long long)w->clock.steps, (double)w->clock.dt, demi_integrator_of(w)->name,
               demi_integrator_of(w)->order);
    if (demi_response_is(w, DEMI_LASTING))
        demi_print(out, "time step  t_c %.4g s, t_c/dt %.1f, limit %s = %.4g s; Rayleigh %.4g s; "
                   "bound by %s\n", (double)a.contact_time,
                   w->clock.dt > 0 ? (double)a.contact_time/(double)w->clock.dt : 0,
                   demi_dt_limit(&a), (double)a.dt_max, (double)a.rayleigh, a.binds);
    demi_held_report(w, out);
    demi_print(out, "search     %s, skin %.3g m, %llu rebuilds, %.1f steps each; per body %.2f "
               "candidates, %.2f contacts\n", demi_searches[w->desc.search].name, w->margin.skin,
               (unsigned long long)w->clock.rebuilds,
               w->clock.rebuilds ? (double)w->clock.steps/(double)w->clock.rebuilds : 0,
               per*c.candidates, per*c.contacts);
    demi_levels_report(w, out);
    demi_laws_report(w, out);
    demi_options_report(w, out);
    demi_shapes_report(w, out);
    demi_print(out, "           bodies %s; walls %d; force field %s; ledger %s; kernel: %s\n",
               w->effects.uniform ? "all alike (coefficients once)" : demi_many_species(w)
                   ? "differ (coefficients per neighbour pair)"
                   : "of few species (coefficients per pair of species)", walls,
               w->desc.force || w->desc.body_force ? "yes" : "no", w->desc.ledger ? "on" : "off",
               demi_stages_name(w));
    demi_idle_report(w, out);
    demi_print(out, "overlap    %.3g of the radius at most so far%s%s\n", w->booked.overlap_max,
               w->booked.crushed.next > 0 ? ", above 0.05 " : "",
               demi_crushed_text(w, crushed, sizeof crushed));
    dem_pairs_print(w, out);
    demi_flows_report(w, out);
    if (w->desc.ledger) demi_ledger_report(w, out);
}
DEM_API void dem_world_report(const dem_world *w, FILE *out) {
    demi_calling was;
    if (demi_null_look(w, __func__, out, "out")) return;
    was = demi_calls(w, __func__, 1);
    demi_report(w, out);
    demi_called(w, was);
}
