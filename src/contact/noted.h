/* ---------------------------------------------------------------------------------------------
   >>noted
   Notes of the contacts of a step, while events are recorded (>>events). The loops that compute
   contact forces call these functions for each contact that acts; each work group writes to its own
   segment, which demi_notes_room has allocated. Writes w->events.noted only.
   --------------------------------------------------------------------------------------------- */

/* Makes room for all contacts that are possible in this step, and empties the segments. Returns 0
   if memory ran out. */
static int demi_notes_room(dem_world *w) {
    demi_events *e = &w->events;
    int d;
    for (d = 0, e->noted_first[0] = 0; d < DEMI_DOMAINS; d++) {
        const int n = d < w->domain_count ? w->domains[d].near_end + w->domains[d].kept_next : 0;
        e->noted_first[d + 1] = e->noted_first[d] + n;
        e->noted_count[d] = 0;
    }
    return DEMI_GROW(w, e->noted, (size_t)e->noted_first[DEMI_DOMAINS]);
}
/* Notes a contact of work group d. If the two do not overlap, it counts only if a law acts. */
static void demi_note(dem_world *w, int d, const demi_noted *n, int overlaps) {
    demi_events *e = &w->events;
    double most = fabs((double)n->force);
    int k;
    for (k = 0; k <= DEMI_E_ROLL; k++) most = DEMI_MAX(most, fabs(n->energy[k]));
    if (overlaps || most > 0) e->noted[e->noted_first[d] + e->noted_count[d]++] = *n;
}
/* Notes the contacts of a tile of work group d: spheres, also those of clusters. */
static void demi_tile_note(dem_world *w, int d, demi_tile *t, const demi_span *span,
                           const demi_run *r) {
    int q, k;
    for (q = 0; q < span->count; q++) {
        const int a = span->a[q], ball = span->ball ? span->ball[q] : -1;
        const dem_real radius = ball < 0 ? w->bodies.pos[4*a + 3] : w->bodies.centre[4*ball + 3];
        demi_noted n;
        if (!(t->touch[q] > 0)) continue;
        n.a = a;
        n.b = span->b[q];
        n.wall = 0;
        n.old = t->overlap[q] - t->closing[q]*r->same.dt > 0;
        n.normal = demi_row(t->normal, q);
        /* the contact point divides the distance as the radii do */
        n.arm = demi_scale(n.normal, radius*t->length[q]/(t->length[q] + t->overlap[q]));
        if (ball >= 0) n.arm = demi_add(n.arm, demi_at(w->bodies.centre + 4*ball));
        n.shift = demi_v(0, 0, 0);
        n.force = -demi_dot(demi_row(t->force, q), n.normal);
        n.energy[DEMI_E_DASHPOT] = (double)(t->part[0][q] + t->part[6][q]);
        for (k = DEMI_E_ELASTIC; k <= DEMI_E_ROLL; k++) n.energy[k] = (double)t->part[k][q];
        demi_note(w, d, &n, t->overlap[q] > 0);
    }
}
/* The force loop of spheres while events are recorded. */
static void demi_pairs_noted(dem_world *w, int d) { demi_pairs_with(w, d, demi_tile_note); }
