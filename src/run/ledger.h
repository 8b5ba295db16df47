/* ---------------------------------------------------------------------------------------------
   >>ledger
   Where the energy went. Laws add what they dissipate and store; moves add the work of gravity and
   fields; walls the work they do. The springs in the tangent planes are the odd one out: what they
   took in and neither hold nor lost to sliding was dissipated by the shear dashpot, or with the
   contact.
   --------------------------------------------------------------------------------------------- */
/* J, of all that moves. */
static void demi_kinetic(const dem_world *w, double *kinetic, double *rotational) {
    int i;
    *kinetic = *rotational = 0;
    for (i = 0; i < w->bodies.count; i++) {
        const dem_real *v = w->bodies.vel + 4*i;
        const double m = (double)w->bodies.mass[i];
        if (w->bodies.inv_mass[i] <= 0) continue;
        *kinetic += m*((double)v[0]*(double)v[0] + (double)v[1]*(double)v[1] +
                       (double)v[2]*(double)v[2])/2;
        *rotational += (double)demi_dot(demi_angular_of(w, i), demi_at(w->bodies.spin + 4*i))/2;
    }
}
/* After a force evaluation: adds the domains' flows to the totals; stored energies replace the
   last. */
static void demi_ledger_book(dem_world *w) {
    static const int flows[] = {DEMI_E_DASHPOT, DEMI_E_SHEAR_WORK, DEMI_E_SLIDE, DEMI_E_ROLL,
                                DEMI_E_FORCE};
    double walls = 0;
    size_t i;
    if (!w->desc.ledger) return;
    for (i = 0; i < sizeof flows/sizeof *flows; i++) {
        const double part = demi_sum_energy(w, flows[i]);
        w->booked.energy[flows[i]] += part;
        if (flows[i] == DEMI_E_FORCE) w->booked.throughput += fabs(part);
    }
    w->booked.energy[DEMI_E_ELASTIC] = demi_sum_energy(w, DEMI_E_ELASTIC);
    w->booked.energy[DEMI_E_SHEAR_STORED] = demi_sum_energy(w, DEMI_E_SHEAR_STORED);
    for (i = DEMI_E_DASHPOT; i <= DEMI_E_ROLL && w->desc.law; i++)
        w->booked.energy[DEMI_E_TOLD] += fabs(demi_sum_energy(w, (int)i));
    for (i = 0; i < (size_t)w->wall_count;
         i++) walls += (double)w->walls[i].loads.power*(w->stage.forces_valid
                                                           ? (double)w->clock.dt : 0);
    w->booked.energy[DEMI_E_WALLS] += walls;
    w->booked.throughput += fabs(walls);
}
DEM_API dem_ledger dem_ledger_get(const dem_world *w) {
    dem_ledger l;
    memset(&l, 0, sizeof l);
    if (!w || !w->desc.ledger) return l;
    demi_kinetic(w, &l.kinetic, &l.rotational);
    l.elastic = w->booked.energy[DEMI_E_ELASTIC] + w->booked.energy[DEMI_E_SHEAR_STORED];
    l.gravity = w->booked.energy[DEMI_E_GRAVITY];
    l.walls = w->booked.energy[DEMI_E_WALLS];
    l.force = w->booked.energy[DEMI_E_FORCE];
    l.inserted = w->booked.inserted;
    l.removed = w->booked.removed;
    l.normal = w->booked.energy[DEMI_E_DASHPOT];
    l.slide = w->booked.energy[DEMI_E_SLIDE];
    l.tangent = w->booked.energy[DEMI_E_SHEAR_WORK] - w->booked.energy[DEMI_E_SLIDE] -
        w->booked.energy[DEMI_E_SHEAR_STORED];
    l.rolling = w->booked.energy[DEMI_E_ROLL];
    l.throughput = w->booked.throughput + w->booked.inserted;
    l.residual = l.kinetic + l.rotational + l.elastic - l.gravity - l.walls - l.force -
        l.inserted + l.removed +
                 l.normal + l.slide + l.tangent + l.rolling;
    if (w->desc.law && !(w->booked.energy[DEMI_E_TOLD] > 0)) {
        l.unknown = l.residual;
        l.residual = 0;
    }
    return l;
}
DEM_API dem_totals dem_totals_get(const dem_world *w) {
    dem_totals t;
    int i;
    memset(&t, 0, sizeof t);
    if (!w) return t;
    demi_kinetic(w, &t.kinetic, &t.rotational);
    for (i = 0; i < w->bodies.count; i++) {
        const double m = (double)w->bodies.mass[i];
        dem_real own[3];
        double x[3], v[3];
        int k;
        if (w->bodies.inv_mass[i] <= 0) continue;
        demi_put(own, demi_angular_of(w, i));
        for (k = 0; k < 3; k++) {
            x[k] = (double)w->bodies.pos[4*i + k];
            v[k] = (double)w->bodies.vel[4*i + k];
        }
        t.mass += m;
        for (k = 0; k < 3; k++) {
            t.centre[k] += m*x[k];
            t.momentum[k] += m*v[k];
            t.angular[k] += m*(x[(k + 1)%3]*v[(k + 2)%3] - x[(k + 2)%3]*v[(k + 1)%3]) +
                (double)own[k];
        }
    }
    for (i = 0; i < 3 && t.mass > 0; i++) t.centre[i] /= t.mass;
    return t;
}
