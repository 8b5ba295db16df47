/* ---------------------------------------------------------------------------------------------
   >>read-tables
   Reading grains: columns and arrays of a file are recognised by their names, and their numbers are
   converted to SI units and stored. All formats of >>read-grains use this part, which owns
   demi_layout and fills dem_grains. A name may have quotes, a unit and a component (velocity:0, vx,
   omega_y, Position.X). If a quantity occurs twice, the first one is used.
   Tests: tests/file/test_read_grains.c, tests/fuzz_grains.c.
   --------------------------------------------------------------------------------------------- */
/* True if this machine stores the lowest byte of a number first. */
static int demi_is_little_endian(void) {
    const uint16_t one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    return first == 1;
}

/* The quantity in a column: position (from _X on), radius, diameter, velocity (from _V on), angular
   velocity (from _W on), material, the same under the name of type, scaled position (an error if
   there is no other), or one that is not used. */
enum { DEMI_COLUMN_X, DEMI_COLUMN_R = 3, DEMI_COLUMN_D, DEMI_COLUMN_V, DEMI_COLUMN_W = 8,
       DEMI_COLUMN_MATERIAL = 11, DEMI_COLUMN_TYPE, DEMI_COLUMN_SCALED, DEMI_COLUMN_OTHER,
       DEMI_COLUMNS_MOST = 256 };
/* The columns of a file. */
typedef struct demi_layout {
    int count, what[DEMI_COLUMNS_MOST];     /* columns; DEMI_COLUMN_... of each */
    double factor[DEMI_COLUMNS_MOST];       /* to SI units */
    int has[DEMI_COLUMN_OTHER + 1];         /* of each quantity: 1 if there is such a column */
} demi_layout;
/* Names in files, in lower case. width 3: a vector, whose name either has a component at its end or
   is that of an array of three components. */
static const struct { const char *name; int what, width; } demi_column_names[] = {
    {"x", DEMI_COLUMN_X, 1}, {"y", DEMI_COLUMN_X + 1, 1}, {"z", DEMI_COLUMN_X + 2, 1},
    {"xu", DEMI_COLUMN_X, 1}, {"yu", DEMI_COLUMN_X + 1, 1}, {"zu", DEMI_COLUMN_X + 2, 1},
    {"xs", DEMI_COLUMN_SCALED, 1}, {"xsu", DEMI_COLUMN_SCALED, 1},
    {"pos", DEMI_COLUMN_X, 3}, {"position", DEMI_COLUMN_X, 3}, {"points", DEMI_COLUMN_X, 3},
    {"coordinates", DEMI_COLUMN_X, 3}, {"r", DEMI_COLUMN_R, 1}, {"radius", DEMI_COLUMN_R, 1},
    {"d", DEMI_COLUMN_D, 1}, {"diameter", DEMI_COLUMN_D, 1}, {"v", DEMI_COLUMN_V, 3},
    {"vel", DEMI_COLUMN_V, 3}, {"velo", DEMI_COLUMN_V, 3}, {"velocity", DEMI_COLUMN_V, 3},
    {"w", DEMI_COLUMN_W, 3}, {"omega", DEMI_COLUMN_W, 3}, {"spin", DEMI_COLUMN_W, 3},
    {"angvel", DEMI_COLUMN_W, 3}, {"angular_velocity", DEMI_COLUMN_W, 3},
    {"angular velocity", DEMI_COLUMN_W, 3}, {"material", DEMI_COLUMN_MATERIAL, 1},
    {"type", DEMI_COLUMN_TYPE, 1}};

/* Names for error messages, in the order of DEMI_COLUMN_X and so on. */
static const char *const demi_quantity[] = {" (x)", " (y)", " (z)", " (r)", " (d)", " (vx)",
    " (vy)", " (vz)", " (wx)", " (wy)", " (wz)", " (material)", " (type)", " (xs)", ""};

static void demi_grains_free(dem_world *w, dem_grains *g) {
    demi_free(w, g->positions);
    demi_free(w, g->radii);
    demi_free(w, g->velocities);
    demi_free(w, g->spins);
    demi_free(w, g->materials);
    memset(g, 0, sizeof *g);
}
/* Allocates the array for a quantity of n grains, if it does not exist. Returns 0 if memory ran
   out. */
static int demi_grains_hold(dem_world *w, dem_grains *g, int what, size_t n) {
    dem_real **reals = what < DEMI_COLUMN_R ? &g->positions : what < DEMI_COLUMN_V ? &g->radii :
        what < DEMI_COLUMN_W ? &g->velocities : &g->spins;
    g->count = (int)n;
    if (what >= DEMI_COLUMN_SCALED) return 1;
    if (what >= DEMI_COLUMN_MATERIAL) {
        if (!g->materials) g->materials = (int32_t *)demi_alloc(w, n + 1, sizeof(int32_t));
        return g->materials != 0;
    }
    if (!*reals) *reals = (dem_real *)demi_alloc(w, reals == &g->radii ? n + 1 : 3*(n + 1),
                                                 sizeof(dem_real));
    return *reals != 0;
}
/* Stores a number of grain i, in SI units. Returns null, or for an error message what was expected
   instead. */
static const char *demi_grains_put(dem_grains *g, size_t i, int what, double value) {
    if (what < DEMI_COLUMN_R) g->positions[3*i + (size_t)what] = (dem_real)value;
    else if (what < DEMI_COLUMN_V) {
        g->radii[i] = (dem_real)(what == DEMI_COLUMN_D ? value/2 : value);
        if (!(g->radii[i] > 0)) return "a radius or diameter is expected, > 0 m; correct it";
    } else if (what < DEMI_COLUMN_W)
        g->velocities[3*i + (size_t)(what - DEMI_COLUMN_V)] = (dem_real)value;
    else if (what < DEMI_COLUMN_MATERIAL)
        g->spins[3*i + (size_t)(what - DEMI_COLUMN_W)] = (dem_real)value;
    else if (what < DEMI_COLUMN_SCALED) {
        if (!(value >= 0 && value < 1e6 && value <= (int)value))
            return "a material is expected, a whole number from 0 to 999999; correct it";
        g->materials[i] = (int32_t)value;
    }
    return 0;
}
/* Returns the factor from a unit to SI units; 0 if the quantity does not have this unit. */
static double demi_column_factor(const char *unit, int what) {
    static const struct { const char *name; double factor; } lengths[] = {
        {"m", 1}, {"mm", 1e-3}, {"cm", 1e-2}, {"um", 1e-6}, {"\xC2\xB5m", 1e-6}};
    size_t k;
    if (!*unit || what >= DEMI_COLUMN_MATERIAL) return 1;
    if (what >= DEMI_COLUMN_W) return !strcmp(unit, "rad/s") || !strcmp(unit, "1/s");
    for (k = 0; k < sizeof lengths/sizeof *lengths; k++) {
        const size_t n = strlen(lengths[k].name);
        if (!strncmp(unit, lengths[k].name, n) &&
            !strcmp(unit + n, what < DEMI_COLUMN_V ? "" : "/s")) return lengths[k].factor;
    }
    return 0;
}
/* Returns the component, 0 to 2, at the end of a name; -1 if there is none. rest: the name after
   its stem. */
static int demi_column_component(const char *rest) {
    static const char letters[] = "xyz", digits[] = "012";
    const int apart = *rest && strchr(":_.[- ", *rest) != 0;
    const char *in;
    rest += apart;
    if (!rest[0] || (rest[1] && (rest[1] != ']' || rest[2]))) return -1;
    in = strchr(letters, rest[0]);
    if (in) return (int)(in - letters);
    in = apart ? strchr(digits, rest[0]) : 0;
    return in ? (int)(in - digits) : -1;
}
/* Returns the quantity (DEMI_COLUMN_...) of component c of an array of this name and width; a
   column has width 1. *factor receives the factor to SI units, 0 if the unit does not suit. */
static int demi_column_of(const char *name, size_t length, int c, int width, double *factor) {
    char stem[64], *unit, *end;
    size_t n = 0, k;
    *factor = 1;
    for (k = 0; k < length && n + 1 < sizeof stem; k++) {
        const char letter = name[k];
        if (letter == '"' || (letter == ' ' && n == 0)) continue;
        stem[n++] = letter >= 'A' && letter <= 'Z' ? (char)(letter - 'A' + 'a') : letter;
    }
    if (k < length) return DEMI_COLUMN_OTHER;
    while (n > 0 && stem[n - 1] == ' ') n--;
    stem[n] = 0;
    unit = strpbrk(stem, "([");
    if (unit && (unit[1] < '0' || unit[1] > '2' || unit[2] != ']')) {
        for (end = unit; end > stem && (end[-1] == ' ' || end[-1] == '_'); end--) {}
        *end = 0;
        unit++;
        unit[strcspn(unit, ")]")] = 0;
    } else unit = stem + n;
    for (k = 0; k < sizeof demi_column_names/sizeof *demi_column_names; k++) {
        const char *is = demi_column_names[k].name;
        int what = demi_column_names[k].what, part;
        if (strncmp(stem, is, strlen(is))) continue;
        part = width == 3 && !stem[strlen(is)] ? c : demi_column_component(stem + strlen(is));
        if (demi_column_names[k].width == 3 ? part < 0 : width != 1 || stem[strlen(is)]) continue;
        if (demi_column_names[k].width == 3) what += part;
        *factor = demi_column_factor(unit, what);
        return what;
    }
    return DEMI_COLUMN_OTHER;
}
/* Adds the name of a column or array that is not used to g->ignored. */
static void demi_grains_ignore(dem_grains *g, const char *name, size_t length) {
    const size_t have = strlen(g->ignored);
    while (length && (*name == '"' || *name == ' ')) { name++; length--; }
    while (length && (name[length - 1] == '"' || name[length - 1] == ' ')) length--;
    if (length && have + length + 3 <= sizeof g->ignored)
        sprintf(g->ignored + have, "%s%.*s", have ? ", " : "", (int)length, name);
}
/* Adds a column (width 1) or the components of an array to the layout. */
static dem_result demi_layout_add(const demi_text *t, demi_layout *l, dem_grains *g,
                                  const char *name, size_t length, int width) {
    int c, k, used = 0;
    for (c = 0; c < width; c++) {
        double factor;
        int what = demi_column_of(name, length, c, width, &factor);
        const int is = what == DEMI_COLUMN_TYPE ? (int)DEMI_COLUMN_MATERIAL : what;
        if (l->count == DEMI_COLUMNS_MOST)
            return demi_fail(t->world, DEM_ERROR_FORMAT, "%s: %s has more than %d columns; leave "
                             "out those that are not needed", t->call, t->name,
                             (int)DEMI_COLUMNS_MOST);
        if (l->has[is] || l->has[what] || (is == DEMI_COLUMN_D && l->has[DEMI_COLUMN_R]) ||
            (is == DEMI_COLUMN_R && l->has[DEMI_COLUMN_D])) what = DEMI_COLUMN_OTHER;
        if (!(factor > 0))
            return demi_fail(t->world, DEM_ERROR_FORMAT, "%s: %s line %ld: the unit of column "
                             "%.*s is not known, must be m, mm, cm or um, with /s for velocities, "
                             "rad/s for spins; use SI units", t->call, t->name, t->line,
                             (int)DEMI_MIN(length, 60), name);
        for (k = 0; k < l->count && what == DEMI_COLUMN_MATERIAL; k++)  /* it replaces a type */
            if (l->what[k] == DEMI_COLUMN_TYPE) l->what[k] = DEMI_COLUMN_OTHER;
        l->has[what] = what < DEMI_COLUMN_OTHER;
        l->factor[l->count] = factor;
        l->what[l->count++] = what;
        used |= what < DEMI_COLUMN_OTHER;
    }
    if (!used) demi_grains_ignore(g, name, length);
    return DEM_OK;
}
/* Fails unless there are x, y and a radius or diameter. */
static dem_result demi_layout_check(const demi_text *t, const demi_layout *l, const dem_grains *g) {
    if (l->has[0] && l->has[1] && (l->has[DEMI_COLUMN_R] || l->has[DEMI_COLUMN_D])) return DEM_OK;
    return demi_fail(t->world, DEM_ERROR_FORMAT, "%s: %s: columns x, y and r (radius) or d "
                     "(diameter) are needed; %s%s%s; name them in the first line, or add them to "
                     "the export", t->call, t->name, l->has[DEMI_COLUMN_SCALED]
                     ? "xs is a fraction of the box, so dump x y z"
                     : g->ignored[0] ? "not used" : "one is missing",
                     g->ignored[0] ? ": " : "", g->ignored);
}
