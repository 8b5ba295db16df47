/* ---------------------------------------------------------------------------------------------
   >>noted
   Notes of the contacts of a step, while events are recorded (>>events). The loops that compute
   contact forces call these functions for each contact that acts; each work group writes to its own
   segment, which demi_notes_room has allocated. Writes w->events.noted, noted_at, noted_first and
   noted_count only.
   --------------------------------------------------------------------------------------------- */

/* Makes room for all contacts that are possible in this step, and empties the segments. Returns 0
   if memory ran out. */
static int demi_notes_room(dem_world *w) {
    demi_events *e = &w->events;
    int d;
    for (d = 0, e->noted_first[0] = 0; d < DEMI_DOMAINS; d++) {
        const int n = d < w->domain_count ? w->domains[d].near_end + w->domains[d].persistent_next
            : 0;
        e->noted_first[d + 1] = e->noted_first[d] + n;
        e->noted_count[d] = 0;
    }
    return DEMI_GROW(w, e->noted, (size_t)e->noted_first[DEMI_DOMAINS]) &&
        DEMI_GROW(w, e->noted_at, (size_t)e->noted_first[DEMI_DOMAINS]);
}
/* Notes a contact of work group d. kind: of DEMI_NOTED_...; energy: J, DEMI_E_DASHPOT to
   DEMI_E_ROLL. If the two do not overlap, it counts only if a law acts. Returns null if it does not
   count, otherwise where to store its place, which two lone spheres do not need. */
DEM_INLINE demi_noted_at *demi_note(dem_world *w, int d, int a, int b, int kind, int overlaps,
                                    dem_real force, const double *energy) {
    demi_events *e = &w->events;
    const int i = e->noted_first[d] + e->noted_count[d];
    demi_noted *n = e->noted + i;
    int k, acts = overlaps || force > 0 || force < 0;
    for (k = 0; k <= DEMI_E_ROLL && !acts; k++) acts = energy[k] > 0 || energy[k] < 0;
    if (!acts) return 0;
    e->noted_count[d]++;
    n->a = a;
    n->b = b;
    n->kind = kind;
    n->force = (double)force;
    n->normal = energy[DEMI_E_DASHPOT];
    n->slide = energy[DEMI_E_SLIDE];
    n->rolling = energy[DEMI_E_ROLL];
    n->work = energy[DEMI_E_SHEAR_WORK];
    n->stored = energy[DEMI_E_SHEAR_STORED];
    return e->noted_at + i;
}
/* Returns the vector from the centre of a sphere to the contact point with another one, m. It
   divides the distance of the centres as the radii do. radii: their sum, m. */
static dem_vec3 demi_note_arm(dem_vec3 normal, dem_real radius, dem_real distance, dem_real radii) {
    return demi_scale(normal, radius*distance/radii);
}
/* Notes the contacts of a tile of work group d. */
static void demi_tile_note(dem_world *w, int d, demi_tile *t, const demi_span *span,
                           const demi_run *r) {
    int q, k;
    for (q = 0; q < span->count; q++) {
        const demi_persistent *c = span->points ? span->points->contact[q] : 0;
        const int old = c ? c->from >= 0 : t->overlap[q] - t->closing[q]*r->same.dt > 0;
        const dem_vec3 normal = demi_row(t->normal, q);
        double energy[DEMI_E_ROLL + 1];
        demi_noted_at *at;
        if (!(t->touch[q] > 0)) continue;
        energy[DEMI_E_DASHPOT] = (double)(t->part[0][q] + t->part[6][q]);
        for (k = DEMI_E_ELASTIC; k <= DEMI_E_ROLL; k++) energy[k] = (double)t->part[k][q];
        at = demi_note(w, d, span->a[q], span->b[q],
                       old*DEMI_NOTED_OLD | !span->points*DEMI_NOTED_SPHERES, t->overlap[q] > 0,
                       -demi_dot(c ? c->force : demi_row(t->force, q), normal), energy);
        if (!at || !span->points) continue;
        at->normal = normal;
        at->arm = demi_rows_at(&span->points->arm[0], q);
        at->shift = c ? c->shift : demi_v(0, 0, 0);
    }
}
