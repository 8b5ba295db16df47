/* rules.h - which rows need others and which exclude each other, beside the groups of draw.h. A scene is drawn so that
   no rule is broken; the page lists the rules, with the reasons. */
#ifndef REL_RULES_H
#define REL_RULES_H

/* Each of `rows` needs (needs 1) or excludes (0) each of `others`; names are separated by commas. */
typedef struct rel_rule { const char *rows; int needs; const char *others, *why; } rel_rule;
#define REL_OWN_LAWS "own law,law by rows,law across gaps,law of numbers,bonds,capillary,charge,DMT,heat,JKR,Luding," \
    "viscoelastic,Walton-Braun"
#define REL_MOVED "translating,rotating,oscillating,user motion,table"
#define REL_SOLIDS "ellipsoids,clusters of one,clusters,cubes,rocks,unions,unions of ellipsoids,unions of polyhedra"
#define REL_FEED_KINDS "feed of classes,endless feed,feed at once,feed by mass,round feed,feed seed,thrown feed," \
    "feed in a window,feed inside,feed of shapes,feed of a material,feed of sizes"
#define REL_WALLED "planes,flat mesh,bumpy mesh,profile,cylinder,revolved,cone,wall of grains,sieve," \
    "periodic floor,outflow,flush boxes"
static const rel_rule rel_rules[] = {
    {"linear,hysteretic,no tangent,viscous,step friction,Mindlin,Mindlin rescaled,constant rolling,EPSD rolling,"
     "clipped,compensated,elastic load,magnitude load,spring slider,remainder slider,forward Euler,symplectic Euler,"
     "position Verlet,leapfrog,chord overlap,normal overlap,separate clusters,"
     "stiffness,servo,cell,spring,no rolling law,step rolling,"
     "rules of the mill,unloading stiffness,stiffness ratio," REL_OWN_LAWS, 1, "springs", "laws of springs"},
    {"Jacobi,APGD,spectral,convex cone,cold start,cohesion,compliance,point joint,hinge,motor,unsolved stops,"
     "impulses at a distance", 1, "impulses", "impulses only"},
    {REL_SOLIDS, 0, "planar", "shapes in three dimensions"},
    {"polygons,concave polygons", 1, "planar", "shapes of the plane"},
    {"flat mesh,bumpy mesh,revolved,cone,wall of grains,sieve,user motion,servo,rod,flush boxes,sheet",
     0, "planar", "drawn in three dimensions"},
    {REL_MOVED ",belt,wall removed,outlet of a wall,rail of a wall,joint to a wall",
     0, "periodic,open", "there is no wall"},
    {"user motion,rod,outflow", 0, "periodic floor", "drawn without periods"},
    {REL_MOVED, 0, REL_MOVED, "one wall has one motion"},
    {"rod", 0, "periodic,open", "there is no floor"},
    {"sheet", 0, "periodic,periodic floor", "drawn without periods"},
    {REL_WALLED, 0, "cell", "a cell has no walls"},
    {"cell", 1, "periodic", "a cell is periodic"},
    {"cell", 0, "feed,outlet,rail,servo", "cell"},
    {"servo", 0, "periodic", "drawn with walls"},
    {"cell shear,cell stress,cell later", 1, "cell", "a kind of it"},
    {"bars,square holes,round holes,slots,reduced holes,two layers,sieve disc", 1, "sieve", "a kind of it"},
    {"thick plate", 1, "square holes", "a kind of it"},
    {"staggered", 1, "round holes", "a kind of it"},
    {"other model,clearance", 1, "reduced holes", "a kind of it"},
    {"two layers", 0, "bars,square holes,round holes,slots,reduced holes", "layers of wires"},
    {"reduced holes", 0, "sieve disc", "reduced holes"},
    {"fractions of segments", 1, "profile", "a kind of it"},
    {"bonds made", 1, "bonds", "a kind of it"},
    {"joint to a wall,joint with contacts", 1, "point joint", "a kind of it"},
    {"named history", 0, "linear,hysteretic,impulses", "the history of a law of one's own"},
    {"user motion with data", 1, "user motion", "a kind of it"},
    {"table repeats", 1, "table", "a kind of it"},
    {"phase", 1, "oscillating", "a kind of it"},
    {"servo stress,servo travel,servo ramp,servo near,servo table", 1, "servo", "a kind of it"},
    {"push of a material,push of a group,push in a cylinder,push of a shape,push of radii,push inside",
     1, "push", "a kind of it"},
    {"members,push of a group,average of a group", 1, "groups", "needs the names of groups"},
    {"torque", 1, "impulses", "impulses only"},
    {"rail of one axis,rail of spins,rail of a wall", 1, "rail", "a kind of it"},
    {REL_FEED_KINDS, 1, "feed", "a kind of it"},
    {"feed", 0, "periodic", "drawn without it"},
    {"outlet beyond,outlet of a material,residence times,outlet of a wall,outlet wanted,outlet classes",
     1, "outlet", "a kind of it"},
    {"average of a group,wide average,variance,average of bodies,"
     "average of a material,average in a window,average of radii",
     1, "average", "a kind of it"},
    {"growth at intervals,growth with data", 1, "growth", "a kind of it"},
    {"numbers with data", 1, "numbers", "a kind of it"},
    {"range in radii", 1, "law across gaps", "a kind of it"},
    {"outline mass,alike spheres,given mass", 1, "clusters", "a kind of it"},
    {"ignored pair", 1, "two materials", "a pair of two"},
    {"rail", 0, "impulses", "rails need springs"},
    {"laid cube", 1, "cubes", "a kind of it"},
    {"laid cube", 0, "DMT,JKR,capillary", "whether it touches is rounding, and the force begins with a jump"},
    {"laid cube", 0, "bumpy mesh,profile,wall of grains,sieve,rod,periodic,open", "there is no flat floor"},
    {"sieve disc,reduced holes,fractions of segments",
     0, "ellipsoids,cubes,rocks,unions,unions of ellipsoids,unions of polyhedra,"
     "polygons,concave polygons", "for spheres only"},
    {"fractions of segments",
     0, "law across gaps,bonds,capillary,JKR,impulses at a distance", "there is no chord across a gap"},
    {"rail", 0, "fixed body", "all axes of a fixed body are locked"},
    {"Jacobi,APGD,spectral", 0, "point joint,hinge,motor,torque", "the solver does not support joints"},
    {"Jacobi,APGD,spectral",
     0, "rolling friction,spinning friction,pair rolling", "the solver does not support moments"},
    {"static friction", 0, "pair friction", "friction_static is not below friction"},
    {"cell shear", 0, "average,push", "regions have no meaning in a sheared cell"},
    {"endless feed", 0, "feed at once", "all at once needs an amount"},
    {"polygons,concave polygons", 0, "user motion,servo", "drawn in three dimensions"},
    {"unloading stiffness,adhesion,pair adhesion", 1, "hysteretic", "coefficients of the hysteretic law"},
    {"unloading stiffness", 1, "stiffness", "needs a stiffness"}
};
enum { REL_RULES = (int)(sizeof rel_rules/sizeof *rel_rules) };
static unsigned char rel_needs[REL_ROWS][REL_ROWS], rel_excludes[REL_ROWS][REL_ROWS];

static int rel_row_of(const char *name, size_t length) {
    int i;
    for (i = 0; i < REL_ROWS; i++)
        if (strlen(rel_features[i].name) == length && !strncmp(rel_features[i].name, name, length)) return i;
    fprintf(stderr, "relations: a rule names %.*s, which is no row\n", (int)length, name);
    exit(2);
}
/* Writes the rows that a text names, and returns their number. */
static int rel_rows_of(const char *names, int *rows) {
    int n = 0;
    while (*names) {
        const size_t length = strcspn(names, ",");
        rows[n++] = rel_row_of(names, length);
        names += length + (names[length] == ',');
    }
    return n;
}
/* Fills rel_needs and rel_excludes: a row needs what the rows need that it needs, and excludes what those exclude. */
static void rel_rules_read(void) {
    static int done;
    int a[REL_ROWS], b[REL_ROWS], r, i, k, j;
    if (done) return;
    done = 1;
    for (r = 0; r < REL_RULES; r++) {
        const int n = rel_rows_of(rel_rules[r].rows, a), m = rel_rows_of(rel_rules[r].others, b);
        for (i = 0; i < n; i++)
            for (k = 0; k < m; k++) {
                if (a[i] == b[k]) continue;
                if (rel_rules[r].needs) rel_needs[a[i]][b[k]] = 1;
                else rel_excludes[a[i]][b[k]] = rel_excludes[b[k]][a[i]] = 1;
            }
    }
    for (i = 0; i < REL_ROWS; i++)
        for (k = 0; k < REL_ROWS; k++)
            rel_excludes[i][k] |= i != k && rel_features[i].group && rel_features[i].group == rel_features[k].group;
    for (j = 0; j < REL_ROWS; j++)
        for (i = 0; i < REL_ROWS; i++)
            for (k = 0; k < REL_ROWS; k++) rel_needs[i][k] |= rel_needs[i][j] && rel_needs[j][k];
    for (i = 0; i < REL_ROWS; i++) {
        for (j = 0; j < REL_ROWS; j++)
            for (k = 0; k < REL_ROWS && rel_needs[i][j]; k++)
                if (rel_excludes[j][k]) rel_excludes[i][k] = rel_excludes[k][i] = 1;
    }
}
/* May a row be added beside those that are marked? */
static int rel_fits(const unsigned char *marked, int row) {
    int k;
    for (k = 0; k < REL_ROWS; k++) if (marked[k] && rel_excludes[row][k]) return 0;
    return 1;
}
static int rel_has_needed(const unsigned char *has, int row) {
    int k;
    for (k = 0; k < REL_ROWS; k++) if (rel_needs[row][k] && !has[k]) return 0;
    return 1;
}
enum { REL_CHOSEN = 7 };
/* Chooses rows that a scene shall have, all equally often, and those that they need: so that rare rows meet, too. */
static void rel_choose(rel_rng *r, unsigned char *chosen) {
    int n, k;
    rel_rules_read();
    memset(chosen, 0, REL_ROWS);
    for (n = 0; n < REL_CHOSEN; n++) {
        const int row = rel_below(r, REL_ROWS);
        int fits = rel_fits(chosen, row);
        for (k = 0; k < REL_ROWS && fits; k++) if (rel_needs[row][k]) fits = rel_fits(chosen, k);
        for (k = 0; k < REL_ROWS && fits; k++) chosen[k] |= k == row || rel_needs[row][k];
    }
}
#endif
