/* ---------------------------------------------------------------------------------------------
   >>ledger
   The account of energy (desc.ledger), and totals of mass, momentum and kinetic energy. Contact
   laws report what they dissipate and store; the step computes the work of gravity, of force fields
   and of walls. This part sums them in w->booked: supplied and dissipated energy since the world
   was created, and the energy stored now. Tangential dissipation is not reported but follows as a
   remainder: the work done against the tangential force, minus what sliding dissipated, minus what
   tangential springs hold now. It contains the losses of tangential dashpots, and the energy that a
   spring held when its contact ended.
   --------------------------------------------------------------------------------------------- */
/* Computes the kinetic and the rotational energy (J) of all bodies that can move. */
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
/* Forces were computed without a step: books what springs hold more than before, because the scene
   has changed and nothing has moved, as `growth`. The tangential part passes through the work
   against the tangential force, so that it does not count as a loss. sag: J, what normal laws will
   lose by hysteresis in the next step, because the contact history is still that of before. */
static void demi_growth_book(dem_world *w, double sag) {
    const double shear = demi_sum_energy(w, DEMI_E_SHEAR_STORED) -
        w->booked.energy[DEMI_E_SHEAR_STORED];
    const double work = demi_sum_energy(w, DEMI_E_ELASTIC) - w->booked.energy[DEMI_E_ELASTIC] +
        shear + sag;
    demi_work_book(w, DEMI_E_GROWTH, work);
    w->booked.energy[DEMI_E_SHEAR_WORK] += shear;
}
/* Closes the account of a step with springs, when its forces are known. Adds the work and losses of
   all domains (work groups) and of walls to the totals, and replaces the stored energies. With a
   user-defined law, DEMI_E_TOLD sums the magnitudes of all that the law reports; while it is 0, the
   law does not fill force->energy. Does nothing unless desc.ledger is set. */
static void demi_ledger_book(dem_world *w) {
    static const int flows[] = {DEMI_E_DASHPOT, DEMI_E_SHEAR_WORK, DEMI_E_SLIDE, DEMI_E_ROLL,
                                DEMI_E_FORCE};
    const double sag = w->stage.forces_valid ? 0 : demi_sum_energy(w, DEMI_E_DASHPOT);
    double walls = 0;
    size_t i;
    if (!w->desc.ledger) return;
    for (i = 0; i < sizeof flows/sizeof *flows; i++) {
        const double part = demi_sum_energy(w, flows[i]) - (flows[i] == DEMI_E_DASHPOT ? sag : 0);
        w->booked.energy[flows[i]] += part;
        if (flows[i] == DEMI_E_FORCE) w->booked.throughput += fabs(part);
    }
    if (!w->stage.forces_valid) demi_growth_book(w, sag);
    w->booked.energy[DEMI_E_ELASTIC] = demi_sum_energy(w, DEMI_E_ELASTIC) + sag;
    w->booked.energy[DEMI_E_SHEAR_STORED] = demi_sum_energy(w, DEMI_E_SHEAR_STORED);
    for (i = DEMI_E_DASHPOT; i <= DEMI_E_ROLL && w->desc.law; i++)
        w->booked.energy[DEMI_E_TOLD] += fabs(demi_sum_energy(w, (int)i));
    for (i = 0; i < (size_t)w->wall_count; i++)
        walls += (double)w->walls[i].loads.power*(w->stage.forces_valid ? (double)w->clock.dt : 0);
    demi_work_book(w, DEMI_E_WALLS, walls);
    if (w->cell.on && w->stage.forces_valid) demi_cell_book(w, w->cell.rate);
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
    l.growth = w->booked.energy[DEMI_E_GROWTH];
    l.cell = w->booked.energy[DEMI_E_CELL];
    l.inserted = w->booked.inserted;
    l.removed = w->booked.removed;
    l.normal = w->booked.energy[DEMI_E_DASHPOT];
    l.slide = w->booked.energy[DEMI_E_SLIDE];
    l.tangent = w->booked.energy[DEMI_E_SHEAR_WORK] - w->booked.energy[DEMI_E_SLIDE] -
        w->booked.energy[DEMI_E_SHEAR_STORED];
    l.rolling = w->booked.energy[DEMI_E_ROLL];
    l.throughput = w->booked.throughput + w->booked.inserted;
    l.residual = l.kinetic + l.rotational + l.elastic - l.gravity - l.walls - l.force - l.cell -
        l.inserted - l.growth + l.removed + l.normal + l.slide + l.tangent + l.rolling;
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
/* Books the energies due in the ledger, once bodies have moved. With springs they are 0. */
static void demi_due_book(dem_world *w) {
    static const int flows[5] = {DEMI_E_DASHPOT, DEMI_E_SLIDE, DEMI_E_ROLL, DEMI_E_WALLS,
                                 DEMI_E_FORCE};
    int i;
    for (i = 0; i < 5; i++) w->booked.energy[flows[i]] += w->booked.due[i];
    w->booked.energy[DEMI_E_SHEAR_WORK] += w->booked.due[1];    /* no springs: all of it slides */
    w->booked.throughput += fabs(w->booked.due[3]) + fabs(w->booked.due[4]);
}
