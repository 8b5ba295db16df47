/* ---------------------------------------------------------------------------------------------
   >>cell
   Periodic cells that deform (dem_cell_set): the flow of the cell, how it moves bodies and changes
   their velocities relative to it, and what contacts see of it. >>stress chooses the rates and
   moves the sides; demi_periods has the images. Owns no data.

   The flow. Let L be the velocity gradient, with the strain rates on its diagonal and the shear
   rate in its first row and second column, and c the velocity of a body relative to the flow
   L (x - mid):
       dx/dt = c + L (x - mid),     m dc/dt = force - m L c                      (SLLOD, [EVA08])
   which is Newton's law for the whole velocity if L is constant and L L = 0 (shear), and otherwise
   contains the force that a homogeneous acceleration of the flow needs. Two bodies whose centres
   are `branch` apart, from a to b, have the relative velocity c_a - c_b - L branch. Neither depends
   on the place, so no face of the cell is special, and c does not change if a body is wrapped.
   Every step moves all positions by L (x - mid) dt + L L (x - mid) dt^2/2 and the sides by the same
   map, so an image stays an image exactly. In the first term x is the position in the middle of the
   drift. So the path is of second order in dt if the integrator is. The c of the Euler schemes
   belongs to one end of the step, and so does x then.
   Energy. The kinetic energy is that of c. The cell supplies the power
       sum over contacts of force on a . L branch - sum over bodies of m c . L c.
   The work of a step is dt times the mean of the powers at its two ends.
   --------------------------------------------------------------------------------------------- */
/* True if images across the y faces are displaced along x. */
static int demi_cell_slid(const dem_world *w) { return w->cell.offset < 0 || w->cell.offset > 0; }
/* True if they are, or will be. */
static int demi_cell_slides(const dem_world *w) {
    return w->cell.desc.shear < 0 || w->cell.desc.shear > 0 || demi_cell_slid(w);
}
/* Parts of a scene that cannot follow a cell. Fields can, unless it is sheared. */
enum { DEMI_CELL_WALLS, DEMI_CELL_RAILS, DEMI_CELL_FEEDS, DEMI_CELL_OUTLETS, DEMI_CELL_FIELDS,
       DEMI_CELL_PARTS };
/* Fails and returns 1: the scene has a part that cannot follow the cell, or is to get it. */
static int demi_cell_bars(dem_world *w, const char *call, int part) {
    static const char *const reason[DEMI_CELL_PARTS] = {
        "walls would not follow it: a grain and its image would touch the same wall at different "
        "velocities; remove all walls, or press with a servo wall instead of the cell",
        "bodies on rails would not follow it: their velocities are not relative to its flow; take "
        "them off their rails (axes 0)",
        "the regions of feeds would not follow it; fill the cell before it deforms",
        "the regions of outlets would not follow it; use dem_body_remove",
        "fields would not follow it: it is sheared, so that images are displaced, which the grids "
        "do not see; use dem_stress_get"};
    demi_refuse(w, call, "the periodic cell deforms or is sheared (dem_cell_set), and %s",
                reason[part]);
    return 1;
}
/* Returns L branch, m/s. */
DEM_INLINE dem_vec3 demi_cell_flow(const dem_world *w, dem_vec3 branch) {
    const demi_strained *c = &w->cell;
    return demi_v((dem_real)c->rate[0]*branch.x + (dem_real)c->shear*branch.y,
                  (dem_real)c->rate[1]*branch.y, (dem_real)c->rate[2]*branch.z);
}
/* Returns the largest speed, m/s, at which the flow can close two bodies that touch. */
static double demi_cell_speed(const dem_world *w) {
    const dem_vec3 rate = w->cell.desc.rate, most = w->cell.desc.rate_most;
    const double norm = (double)DEMI_MAX(demi_size(rate), demi_size(most)) +
        fabs((double)w->cell.desc.shear);
    double radius = 0;
    int i;
    for (i = 0; i < w->bodies.count; i++) radius = DEMI_MAX(radius, (double)demi_radius(w, i));
    return 2*radius*norm;
}
/* Adds a contact to the virial. force: N, on a. */
DEM_INLINE void demi_virial_add(double *sum, dem_vec3 force, dem_vec3 branch) {
    const double x = (double)branch.x, y = (double)branch.y, z = (double)branch.z;
    sum[0] += (double)force.x*x; sum[1] += (double)force.x*y; sum[2] += (double)force.x*z;
    sum[3] += (double)force.y*x; sum[4] += (double)force.y*y; sum[5] += (double)force.y*z;
    sum[6] += (double)force.z*x; sum[7] += (double)force.z*y; sum[8] += (double)force.z*z;
}
/* True in the steps that sum stiffness and damping, for an axis that is led to a stress. */
enum { DEMI_CELL_REST = 8 };
DEM_INLINE int demi_cell_stiffens(const dem_world *w) {
    const dem_vec3 most = w->cell.desc.rate_most;
    return (most.x > 0 || most.y > 0 || most.z > 0) &&
        (w->clock.steps%DEMI_CELL_REST == 0 || !(w->cell.stiffness[0] > 0));
}
/* Adds the stiffness (N/m) and damping (N s/m) of a contact along its normal n: a strain e of axis
   i moves b by e branch_i relative to a, which changes the force along the axis by
   e k n_i n_i branch_i. kn, kun, cn: coefficients of the normal law. */
static void demi_cell_stiffen(const dem_world *w, double *sum, dem_vec3 n, dem_vec3 branch,
                              dem_real kn, dem_real kun, dem_real cn, double overlap,
                              double share) {
    const double x[3] = {(double)(n.x*branch.x), (double)(n.y*branch.y), (double)(n.z*branch.z)};
    double k = (double)kn, c = (double)cn;
    int i;
    if (demi_normal_is(w, DEMI_HERTZIAN)) { k *= 1.5*sqrt(overlap); c *= sqrt(sqrt(overlap)); }
    if (demi_normal_is(w, DEMI_BRANCHED)) k = (double)kun;
    if (w->desc.law && w->desc.law_stiffness > 0) k = (double)w->desc.law_stiffness;
    for (i = 0; i < 3; i++) {
        sum[DEMI_CELL_STIFF + i] += share*k*x[i]*x[i];
        sum[DEMI_CELL_DAMP + i] += share*c*x[i]*x[i];
    }
}
/* Returns L dt + L L dt^2/2: by[k] on the diagonal; the return value is in row 0, column 1. */
static double demi_cell_map(const dem_world *w, double *by) {
    const demi_strained *c = &w->cell;
    const double dt = (double)w->clock.dt;
    int k;
    for (k = 0; k < 3; k++) by[k] = c->rate[k]*dt*(1 + c->rate[k]*dt/2);
    return c->shear*dt*(1 + (c->rate[0] + c->rate[1])*dt/2);
}
/* Moves the bodies begin .. end - 1 with the flow, for one step. */
static void demi_cell_carry(dem_world *w, int begin, int end) {
    const demi_strained *c = &w->cell;
    const dem_real dt = w->clock.dt, back = demi_integrator_of(w)->back*dt;
    double by[3], shear = demi_cell_map(w, by);
    int i, k;
    for (i = begin; i < end; i++) {
        dem_real *x = w->bodies.pos + 4*i, flow[3];
        const double to[3] = {(double)x[0] - c->mid[0], (double)x[1] - c->mid[1],
                              (double)x[2] - c->mid[2]};
        demi_put(flow, demi_scale(demi_cell_flow(w, demi_at(w->bodies.half_vel + 4*i)), back*dt));
        for (k = 0; k < 3; k++) {
            const dem_real was = x[k];
            x[k] = (dem_real)((double)x[k] + by[k]*to[k] + (k ? 0 : shear*to[1]) - (double)flow[k]);
            if (w->bodies.backward) w->bodies.last_pos[4*i + k] += x[k] - was;
        }
    }
}
/* Adds the force -m L c to the bodies of a work group, and their m c c to its sums. */
static void demi_cell_drag(dem_world *w, demi_domain *domain) {
    double *flux = domain->cell + DEMI_CELL_FLUX;
    int i, k;
    for (i = domain->begin; i < domain->end; i++) {
        const dem_vec3 v = demi_at(w->bodies.vel + 4*i);
        const dem_vec3 drag = demi_scale(demi_cell_flow(w, v), -w->bodies.mass[i]);
        const double m = (double)w->bodies.mass[i];
        const double c[3] = {(double)v.x, (double)v.y, (double)v.z};
        for (k = 0; k < 6; k++) flux[k] += m*(k < 3 ? c[k]*c[k] : c[k > 4]*c[k == 3 ? 1 : 2]);
        w->bodies.force[4*i] += drag.x;
        w->bodies.force[4*i + 1] += drag.y;
        w->bodies.force[4*i + 2] += drag.z;
    }
}
/* Adds half the work of the cell in a step to the ledger, at its beginning and at its end. drag:
   strain rates at which demi_cell_drag was computed. */
static void demi_cell_book(dem_world *w, const double *drag) {
    const demi_strained *c = &w->cell;
    double power = 0;
    int d, k;
    for (d = 0; d < w->domain_count; d++) {
        const double *sum = w->domains[d].cell, *flux = sum + DEMI_CELL_FLUX;
        for (k = 0; k < 3; k++) power += c->rate[k]*sum[DEMI_CELL_VIRIAL + 4*k] - drag[k]*flux[k];
        power += c->shear*(sum[DEMI_CELL_VIRIAL + 1] - flux[3]);
    }
    demi_work_book(w, DEMI_E_CELL, power*(double)w->clock.dt/2);
}
/* Takes the images across the y faces that are nearest along x; only when lists are rebuilt. */
static void demi_cell_upright(dem_world *w) {
    if (w->cell.on && w->cell.side[0] > 0)
        w->cell.offset -= w->cell.side[0]*floor(w->cell.offset/w->cell.side[0] + 0.5);
}
