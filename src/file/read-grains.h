/* ---------------------------------------------------------------------------------------------
   >>read-grains
   Reading grains from files of other programs. Text and CSV, extended XYZ, and dumps of LAMMPS and
   LIGGGHTS have one line for each grain. VTK, VTP and VTU have one array for each quantity, as text
   or as bytes. >>read-tables recognises quantities by name. This part fills dem_grains, and only
   dem_grains_add adds bodies to a world. As in >>read, the contents are not trusted: counts are
   compared with the number of bytes.
   Tests: tests/file/test_read_grains.c, tests/fuzz_grains.c.
   --------------------------------------------------------------------------------------------- */
/* ---- rows ---- */

/* Moves to the next cell of the line. Returns 0 if there is none. `between` is the separator; a
   blank stands for any number of blanks and tabs. A cell may be quoted. Outside quotes, # begins a
   comment. */
static int demi_cell(demi_text *t, char between) {
    const char *p = t->at, *end = t->next, *from;
    if (!p) return 0;                           /* the cell before this one was the last */
    while (end > p && (end[-1] == '\n' || end[-1] == '\r')) end--;
    while (p < end && (*p == ' ' || (*p == '\t' && between != '\t'))) p++;
    from = p;
    if (p < end && *p == '"') {
        const char *close = p + 1;              /* "" within quotes is a quote */
        while (close < end && (*close != '"' || (close + 1 < end && close[1] == '"')))
            close += *close == '"' ? 2 : 1;
        if (close < end) {
            t->word = p + 1;
            t->length = (size_t)(close - p) - 1;
            p = close + 1;
            from = 0;
        }
    }
    while (p < end && *p != '#' && *p != between && !(between == ' ' && *p == '\t')) p++;
    t->at = p < end && *p != '#' ? p + 1 : 0;
    if (from) {
        t->word = from;
        while (p > from && (p[-1] == ' ' || p[-1] == '\t')) p--;
        t->length = (size_t)(p - from);
    }
    return between != ' ' || t->length > 0;
}
/* Returns the beginning of the current line, with its leading blanks. */
static const char *demi_line_begin(const demi_text *t) {
    const char *line = t->word;
    while (line > t->data && line[-1] != '\n' && line[-1] != '\r') line--;
    return line;
}
/* Returns the separator of a line: a semicolon if there is one, else a tab if there are at least
   two, else a comma if there is one, else a blank. A single tab may be used as a blank. */
static char demi_between(const char *line, const char *end) {
    const char *p;
    int tabs = 0, comma = 0, quoted = 0;
    for (p = line; p < end && *p != '#' && *p != '\n' && *p != '\r'; p++) {
        quoted ^= *p == '"';
        if (quoted) continue;
        if (*p == ';') return ';';
        tabs += *p == '\t';
        comma |= *p == ',';
    }
    return tabs > 1 ? '\t' : comma ? ',' : ' ';
}
/* Reads the current cell as a number. It may have a decimal comma if semicolons or tabs separate
   the cells. */
static dem_result demi_cell_number(const demi_text *t, char between, double *value) {
    demi_text cell = *t;
    char copy[128];
    const char *comma = between == ';' || between == '\t' ?
        (const char *)memchr(t->word, ',', t->length) : 0;
    if (comma && t->length < sizeof copy && !memchr(t->word, '.', t->length)) {
        memcpy(copy, t->word, t->length);
        copy[comma - t->word] = '.';
        cell.word = copy;
    }
    return demi_text_number(&cell, value);
}
/* Ignores column k, a type that cannot be the number of a material, such as a name. */
static void demi_layout_untype(const demi_text *t, demi_layout *l, dem_grains *g, int k) {
    l->what[k] = DEMI_COLUMN_OTHER;
    demi_free(t->world, g->materials);
    g->materials = 0;
    demi_grains_ignore(g, "type", 4);
}
/* Reads the current line into grain i. */
static dem_result demi_grain_line(demi_text *t, demi_layout *l, char between, dem_grains *g,
                                  size_t i) {
    int k;
    t->at = demi_line_begin(t);
    for (k = 0; k < l->count; k++) {
        const int there = demi_cell(t, between), what = l->what[k];
        const char *wrong;
        double value = 0;
        if (!there) t->length = 0;
        if (!there && between == ' ')
            return demi_text_fail(t, "a number is expected for each column; add what is missing or "
                                  "correct the names of the columns");
        if (what == DEMI_COLUMN_OTHER && there) continue;
        if (!t->length)
            return demi_fail(t->world, DEM_ERROR_FORMAT, "%s: %s line %ld: cell %d%s is empty, "
                             "must be a number for each column; fill it in, or remove its column",
                             t->call, t->name, t->line, k + 1, demi_quantity[what]);
        if (what == DEMI_COLUMN_TYPE && !(*t->word >= '0' && *t->word <= '9')) {
            demi_layout_untype(t, l, g, k);
            continue;
        }
        if (demi_cell_number(t, between, &value) != DEM_OK) return DEM_ERROR_FORMAT;
        wrong = demi_grains_put(g, i, what, value*l->factor[k]);
        if (wrong && what == DEMI_COLUMN_TYPE) demi_layout_untype(t, l, g, k);
        else if (wrong) return demi_text_fail(t, wrong);
    }
    while (demi_cell(t, between))
        if (t->length)
            return demi_text_fail(t, "the line should end: it has more columns than the first "
                                  "line; write numbers with a point, or with a comma where ; or "
                                  "tabs separate columns");
    return DEM_OK;
}
/* Reads lines as grains: `said` lines, or with -1 all lines up to the end of the text. Counts the
   remaining lines in g->lines_left. */
static dem_result demi_grains_rows(demi_text *t, demi_layout *l, char between, double said,
                                   dem_grains *g) {
    demi_text at = *t;
    size_t n = 0, i;
    int k;
    dem_result result = demi_layout_check(t, l, g);
    if (result != DEM_OK) return result;
    while ((said < 0 || (double)n < said) && demi_text_line(&at)) n++;
    if (said > (double)n)
        return demi_fail(t->world, DEM_ERROR_FORMAT, "%s: %s: has %.0f lines of grains where its "
                         "head announces %.0f; the file was cut short", t->call, t->name, (double)n,
                         said);
    if (n > (size_t)(INT_MAX/64)) return demi_text_memory(t);
    for (k = 0; k < l->count; k++)
        if (!demi_grains_hold(t->world, g, l->what[k], n)) return demi_text_memory(t);
    for (i = 0; i < n && result == DEM_OK; i++) {
        demi_text_line(t);
        result = demi_grain_line(t, l, between, g, i);
    }
    while (demi_text_line(&at)) g->lines_left++;
    return result;
}
/* Fills in the layout from a line of column names. `between` is the separator, an underscore in the
   #format comments of YADE. */
static dem_result demi_layout_line(const demi_text *t, const char *line, char between,
                                   demi_layout *l, dem_grains *g) {
    demi_text at = *t;
    dem_result result = DEM_OK;
    memset(l, 0, sizeof *l);
    g->ignored[0] = 0;
    at.at = line;
    while (result == DEM_OK && demi_cell(&at, between)) {
        if (!at.length && !at.at) break;        /* a separator at the end */
        result = demi_layout_add(&at, l, g, at.word, at.length, 1);
    }
    return result;
}
/* Fills in the layout from comments at the beginning, such as "#format x_y_z_r" (YADE) or
   "# x y z r". *named receives 1 if one of them names a position and a radius or diameter. `line`
   is the first line that is no comment. */
static dem_result demi_layout_comment(const demi_text *t, const char *line, demi_layout *l,
                                      dem_grains *g, int *named) {
    const char *p = t->data, *end;
    demi_layout none;
    dem_result result = DEM_OK;
    for (*named = 0; p < line && !*named; p = end + 1) {
        demi_text at = *t;
        end = (const char *)memchr(p, '\n', (size_t)(line - p));
        if (!end) break;
        while (p < end && (*p == ' ' || *p == '\t')) p++;
        if (p == end || *p != '#') continue;
        at.next = end;
        p++;
        if (end - p > 7 && !memcmp(p, "format ", 7))
            result = demi_layout_line(&at, p + 7, '_', l, g);
        else result = demi_layout_line(&at, p, demi_between(p, end), l, g);
        *named = result == DEM_OK && l->has[0] && l->has[1] &&
            (l->has[DEMI_COLUMN_R] || l->has[DEMI_COLUMN_D]);
    }
    memset(&none, 0, sizeof none);
    if (!*named) { *l = none; g->ignored[0] = 0; }
    return DEM_OK;
}
/* Reads text with or without column names. t: at its first line. */
static dem_result demi_grains_text(demi_text *t, demi_layout *l, dem_grains *g) {
    const char *line = demi_line_begin(t);
    demi_text before, at;
    char between, said = 0;
    int named, k, cells = 0, numbers = 1;
    dem_result result;
    if (t->length >= 4 && !memcmp(t->word, "sep=", 4)) {    /* the separator of a spreadsheet */
        said = t->length > 4 ? t->word[4] : '\t';
        if (!demi_text_line(t)) return demi_text_fail(t, "grains are expected; is the file empty?");
        line = demi_line_begin(t);
    }
    result = demi_layout_comment(t, line, l, g, &named);
    between = said ? said : demi_between(line, t->next);
    before = at = *t;
    for (at.at = line; demi_cell(&at, between); cells++) {
        if (!at.length && !at.at) break;
        numbers &= !at.length || (*at.word && strchr("0123456789+-.", *at.word));
    }
    if (!named && !numbers) {
        result = demi_layout_line(t, line, between, l, g);
        for (k = named = 0; k <= DEMI_COLUMN_SCALED; k++) named |= l->has[k];
        if (result == DEM_OK && !named)
            return demi_text_fail(t, "numbers are expected, or names of columns (x y z r ...)");
        return result == DEM_OK ? demi_grains_rows(t, l, between, -1, g) : result;
    }
    if (!named) {
        if (cells != 4 && cells != 7)
            return demi_text_fail(t, "4 columns are expected (x y z r), or 7 (and vx vy vz), or a "
                                  "first line that names them");
        result = demi_layout_add(t, l, g, "position", 8, 3);
        if (result == DEM_OK) result = demi_layout_add(t, l, g, "r", 1, 1);
        if (result == DEM_OK && cells == 7) result = demi_layout_add(t, l, g, "v", 1, 3);
    }
    before.next = line;                         /* go back: this line is the first grain */
    before.line--;
    return result == DEM_OK ? demi_grains_rows(&before, l, between, -1, g) : result;
}
/* Reads extended XYZ: a line with the number of grains, then a line that describes the columns as
   Properties=name:type:columns:name:type:columns and so on, possibly in quotes. t is at the number
   of grains. */
static dem_result demi_grains_xyz(demi_text *t, double count, demi_layout *l, dem_grains *g) {
    static const char word[] = "Properties=";
    const size_t n = sizeof word - 1;
    const char *p = t->next, *end = p;
    dem_result result = DEM_OK;
    while (end < t->end && *end != '\n' && *end != '\r') end++;
    while (p + n <= end && memcmp(p, word, n)) p++;
    for (p += n + (p + n < end && p[n] == '"'); p < end && *p != ' ' && *p != '\t' && *p != '"';) {
        const char *name = p, *stop;
        int times = 0, colons = 0;
        while (p < end && *p != ':' && *p != ' ') p++;
        stop = p;
        for (; p < end && colons < 2 && *p != ' '; p++) colons += *p == ':';
        while (p < end && *p >= '0' && *p <= '9' && times < 1000) times = 10*times + (*p++ - '0');
        if (colons < 2 || times < 1) { l->count = 0; break; }
        result = demi_layout_add(t, l, g, name, (size_t)(stop - name), times);
        if (result != DEM_OK) return result;
        if (p < end && *p == ':') p++;
    }
    if (!l->count) {
        demi_text_line(t);
        return demi_text_fail(t, "an XYZ file is expected to name its columns "
                              "(Properties=species:S:1:pos:R:3:radius:R:1); write it with radii, "
                              "or use text with columns x y z r");
    }
    if (end < t->end) end += *end == '\r' && t->end - end > 1 && end[1] == '\n' ? 2 : 1;
    t->next = end;
    t->line++;
    return demi_grains_rows(t, l, ' ', count, g);
}
/* Reads the first frame of a dump of LAMMPS or LIGGGHTS. It has lines that begin with "ITEM:", and
   the last of these names the columns. */
static dem_result demi_grains_dump(demi_text *t, demi_layout *l, dem_grains *g) {
    int32_t count = -1;
    dem_result result;
    do {
        if (!demi_text_is(t, "item:") || !demi_text_word(t)) continue;
        if (demi_text_is(t, "number")) {
            demi_text_line(t);
            if (!demi_text_integer(t, t->length, &count) || count < 0)
                return demi_text_fail(t, "the number of atoms is expected, a whole number");
        } else if ((demi_text_is(t, "atoms") || demi_text_is(t, "entries")) && count >= 0) {
            result = demi_layout_line(t, t->at, ' ', l, g);
            return result == DEM_OK ? demi_grains_rows(t, l, ' ', count, g) : result;
        }
    } while (demi_text_line(t));
    return demi_text_fail(t, "ITEM: NUMBER OF ATOMS and ITEM: ATOMS are expected, and their lines; "
                          "the dump was cut short");
}

/* ---- arrays ---- */

/* A sequence of numbers, either words of a text or bytes. */
typedef struct demi_numbers {
    demi_text *text;               /* null: bytes */
    const unsigned char *at, *end; /* of bytes: those that are left */
    int size, kind, big;           /* bytes of a number; 'f', 'i' or 'u'; 1: big-endian */
} demi_numbers;
/* Sets size and kind from the name of a type in VTP or VTK. Returns 0 if the name is unknown. */
static int demi_numbers_type(demi_numbers *in, const char *name, size_t length) {
    static const struct { const char *name; int size, kind; } types[] = {
        {"Float64", 8, 'f'}, {"Float32", 4, 'f'}, {"Int64", 8, 'i'}, {"UInt64", 8, 'u'},
        {"Int32", 4, 'i'}, {"UInt32", 4, 'u'}, {"Int16", 2, 'i'}, {"UInt16", 2, 'u'},
        {"Int8", 1, 'i'}, {"UInt8", 1, 'u'}, {"double", 8, 'f'}, {"float", 4, 'f'},
        {"vtktypeint64", 8, 'i'}, {"long", 8, 'i'}, {"unsigned_long", 8, 'u'}, {"int", 4, 'i'},
        {"unsigned_int", 4, 'u'}, {"vtkIdType", 4, 'i'}, {"short", 2, 'i'},
        {"unsigned_short", 2, 'u'}, {"char", 1, 'i'}, {"unsigned_char", 1, 'u'}};
    size_t k;
    for (k = 0; k < sizeof types/sizeof *types; k++)
        if (strlen(types[k].name) == length && !memcmp(types[k].name, name, length)) {
            in->size = types[k].size;
            in->kind = types[k].kind;
            return 1;
        }
    return 0;
}
/* True if `count` numbers can be left. A word and the blank before it take at least two bytes. */
static int demi_numbers_there(const demi_numbers *in, double count) {
    return in->text ? 2*count <= (double)(in->text->end - in->text->at) + 1
                    : count*in->size <= (double)(in->end - in->at);
}
/* Returns the number that is stored in `size` bytes at `at`. */
static double demi_number_of(const unsigned char *at, int size, int kind, int big) {
    uint64_t bits = 0;
    uint32_t half;
    double wide;
    float narrow;
    int k;
    for (k = 0; k < size; k++) bits = bits << 8 | at[big ? k : size - 1 - k];
    if (kind == 'f') {
        half = (uint32_t)bits;
        memcpy(&wide, &bits, sizeof wide);
        memcpy(&narrow, &half, sizeof narrow);
        return size == 8 ? wide : (double)narrow;
    }
    if (kind == 'i' && size < 8 && bits >> (8*size - 1)) return (double)bits - ldexp(1, 8*size);
    return kind == 'i' && bits >> 63 ? -(double)(~bits + 1) : (double)bits;
}
/* Reads the next number. With used = 0 it is skipped; otherwise it must be within 1e15. */
static dem_result demi_numbers_next(const demi_text *t, demi_numbers *in, int used, double *value) {
    if (in->text) {
        if (!demi_text_word(in->text) && !demi_text_line(in->text))
            return demi_text_fail(in->text, "a number is expected; the file was cut short");
        return used ? demi_text_number(in->text, value) : DEM_OK;
    }
    *value = demi_number_of(in->at, in->size, in->kind, in->big);
    in->at += in->size;
    if (!used || fabs(*value) <= DEMI_FARTHEST) return DEM_OK;
    return demi_fail(t->world, DEM_ERROR_FORMAT, "%s: %s: found a number of %g in an array, must "
                     "be within +-1e15; write the file again", t->call, t->name, *value);
}
/* Reads an array of n x width numbers, and stores those of known quantities. With used = 0, or if
   no quantity is known, it skips the array. */
static dem_result demi_array_read(const demi_text *t, demi_numbers *in, demi_layout *l,
                                  dem_grains *g, const char *name, size_t length, size_t n,
                                  int width, int used) {
    const int from = l->count;
    size_t i;
    int c;
    dem_result result = DEM_OK;
    if (width < 1 || width > DEMI_COLUMNS_MOST || n > (size_t)(INT_MAX/64) ||
        !demi_numbers_there(in, (double)n*width))
        return demi_fail(t->world, DEM_ERROR_FORMAT, "%s: %s: array %.*s of %.0f x %d numbers is "
                         "cut short; write the file again", t->call, t->name,
                         (int)DEMI_MIN(length, 60), name, (double)n, width);
    if (used && l->count && n != (size_t)g->count)
        return demi_fail(t->world, DEM_ERROR_FORMAT, "%s: %s: array %.*s has %.0f points, must "
                         "have %d like the arrays before it; write the file again, with one set "
                         "of points", t->call, t->name, (int)DEMI_MIN(length, 60), name, (double)n,
                         g->count);
    if (used) result = demi_layout_add(t, l, g, name, length, width);
    for (c = from, used = 0; c < l->count && result == DEM_OK; c++) {
        used |= l->what[c] != DEMI_COLUMN_OTHER;
        if (!demi_grains_hold(t->world, g, l->what[c], n)) return demi_text_memory(t);
    }
    if (!in->text && !used) in->at += n*(size_t)width*(size_t)in->size;
    else for (i = 0; i < n; i++)
        for (c = 0; c < width && result == DEM_OK; c++) {
            const int what = used ? l->what[from + c] : (int)DEMI_COLUMN_OTHER;
            const char *wrong = 0;
            double value = 0;
            result = demi_numbers_next(t, in, what != DEMI_COLUMN_OTHER, &value);
            if (result == DEM_OK && what != DEMI_COLUMN_OTHER)
                wrong = demi_grains_put(g, i, what, value*l->factor[from + c]);
            if (wrong)
                return demi_fail(t->world, DEM_ERROR_FORMAT, "%s: %s: point %.0f has %g in array "
                                 "%.*s where %s", t->call, t->name, (double)i, value,
                                 (int)DEMI_MIN(length, 60), name, wrong);
        }
    return result;
}

/* A legacy VTK file being read. */
typedef struct demi_vtk_in {
    demi_text *t;
    demi_layout *l;
    dem_grains *g;
    int binary, at_points;         /* 1: numbers are bytes; 1: the arrays now are those of points */
    double points, cells;          /* their number; -1: not known yet */
} demi_vtk_in;
/* Returns the current word as a count; -1 if it is none. */
static double demi_vtk_count(demi_text *t) {
    int32_t count = -1;
    return t->length && demi_text_integer(t, t->length, &count) && count >= 0 ? count : -1;
}
/* Reads an array of tuples x width numbers of a type, which begins after this line. */
static dem_result demi_vtk_array(demi_vtk_in *v, const char *name, size_t length, double tuples,
                                 double width, const char *type, size_t type_length, int used) {
    demi_text *t = v->t;
    demi_numbers in;
    dem_result result;
    memset(&in, 0, sizeof in);
    if (tuples < 0 || width < 1 || width > (int)DEMI_COLUMNS_MOST ||
        !demi_numbers_type(&in, type, type_length))
        return demi_text_fail(t, "an array with a name, counts and a type is expected; export the "
                              "file as ASCII or as VTP");
    if (!v->binary) in.text = t;
    t->at = t->line_end;
    in.big = 1;
    in.at = (const unsigned char *)t->next;
    in.end = (const unsigned char *)t->end;
    if (in.text) t->at = t->line_end = t->next;     /* demi_numbers_there measures from here */
    result = demi_array_read(t, &in, v->l, v->g, name, length, (size_t)tuples, (int)width, used);
    if (v->binary) t->next = (const char *)in.at;
    else if (result == DEM_OK && demi_text_word(t)) {   /* keep the rest of the last line */
        t->next = t->word;
        t->line--;
    }
    return result;
}
/* Reads the arrays of a FIELD section, each of which begins with a line of name, width, number of
   tuples and type. */
static dem_result demi_vtk_field(demi_vtk_in *v, double arrays) {
    dem_result result = DEM_OK;
    while (arrays > 0 && result == DEM_OK && demi_text_line(v->t)) {
        const char *name = v->t->word, *type;
        const size_t length = v->t->length;
        double width, tuples;
        if (demi_text_is(v->t, "metadata") || demi_text_is(v->t, "information") ||
            demi_text_is(v->t, "name") || demi_text_is(v->t, "data")) continue;
        demi_text_word(v->t);
        width = demi_vtk_count(v->t);
        demi_text_word(v->t);
        tuples = demi_vtk_count(v->t);
        demi_text_word(v->t);
        type = v->t->word;
        result = demi_vtk_array(v, name, length, tuples, width, type, v->t->length,
                                v->at_points && tuples >= v->points && tuples <= v->points);
        arrays--;
    }
    return result;
}
/* Reads the section that begins with the current word. A line that begins no such section, such as
   METADATA or numbers, is skipped. */
static dem_result demi_vtk_section(demi_vtk_in *v) {
    static const char *const cells[] = {"vertices", "lines", "polygons", "triangle_strips",
                                        "cells", "cell_types"};
    demi_text *t = v->t;
    const char *name;
    size_t length, k;
    double count;
    if (demi_text_is(t, "points")) {
        demi_text_word(t);
        v->points = count = demi_vtk_count(t);
        demi_text_word(t);
        return demi_vtk_array(v, "points", 6, count, 3, t->word, t->length, 1);
    }
    if (demi_text_is(t, "point_data")) v->at_points = v->points >= 0;
    if (demi_text_is(t, "cell_data")) {
        v->at_points = 0;
        demi_text_word(t);
        v->cells = demi_vtk_count(t);
        return DEM_OK;
    }
    if (demi_text_is(t, "field")) {
        demi_text_word(t);
        demi_text_word(t);
        return demi_vtk_field(v, demi_vtk_count(t));
    }
    if (demi_text_is(t, "scalars") || demi_text_is(t, "vectors") || demi_text_is(t, "normals")) {
        const int scalars = demi_text_is(t, "scalars");
        const char *type;
        size_t type_length;
        demi_text_word(t);
        name = t->word;
        length = t->length;
        demi_text_word(t);
        type = t->word;
        type_length = t->length;
        count = !scalars ? 3 : demi_text_word(t) ? demi_vtk_count(t) : 1;
        if (scalars) {
            demi_text look = *t;
            if (demi_text_line(&look) && demi_text_is(&look, "lookup_table")) *t = look;
        }
        return demi_vtk_array(v, name, length, v->at_points ? v->points : v->cells, count, type,
                              type_length, v->at_points);
    }
    for (k = 0; v->binary && k < sizeof cells/sizeof *cells; k++) {     /* skip bytes of cells */
        if (!demi_text_is(t, cells[k])) continue;
        demi_text_word(t);
        count = demi_vtk_count(t);
        if (demi_text_word(t)) {                /* ints; from format 5.1 on two arrays */
            demi_text look = *t;
            if (demi_text_line(&look) && demi_text_is(&look, "offsets")) {
                const double corners = demi_vtk_count(t);
                dem_result result;
                *t = look;
                demi_text_word(t);
                result = demi_vtk_array(v, "", 0, count, 1, t->word, t->length, 0);
                if (result != DEM_OK) return result;
                demi_text_line(t);              /* CONNECTIVITY */
                demi_text_word(t);
                return demi_vtk_array(v, "", 0, corners, 1, t->word, t->length, 0);
            }
            count = demi_vtk_count(t);
        }
        return demi_vtk_array(v, "", 0, count, 1, "int", 3, 0);
    }
    return DEM_OK;
}
/* Reads grains from a legacy VTK file. t: at its beginning. */
static dem_result demi_grains_vtk(demi_text *t, demi_layout *l, dem_grains *g) {
    demi_vtk_in v = {t, l, g, 0, 0, -1, -1};
    dem_result result = DEM_OK;
    int k;
    for (k = 0; k < 2; k++) {                   /* skip version and title */
        const char *end = (const char *)memchr(t->next, '\n', (size_t)(t->end - t->next));
        t->next = end ? end + 1 : t->end;
        t->line++;
    }
    demi_text_line(t);
    v.binary = demi_text_is(t, "binary");
    if (!v.binary && !demi_text_is(t, "ascii"))
        return demi_text_fail(t, "ASCII or BINARY is expected; export the file again");
    while (result == DEM_OK && demi_text_line(t)) result = demi_vtk_section(&v);
    return result == DEM_OK ? demi_layout_check(t, l, g) : result;
}

/* ---- VTP and VTU ---- */

/* Returns the value of an attribute of a tag, which reaches from `tag` to `end`; null if it has no
   such attribute. *size receives the length of the value. */
static const char *demi_attribute(const char *tag, const char *end, const char *name,
                                  size_t *size) {
    const size_t n = strlen(name);
    const char *p, *stop;
    for (p = tag + 1; p + n + 2 < end; p++) {
        if (!strchr(" \t\r\n", p[-1]) || memcmp(p, name, n) || p[n] != '=' || p[n + 1] != '"')
            continue;
        stop = (const char *)memchr(p + n + 2, '"', (size_t)(end - p) - n - 2);
        if (!stop) return 0;
        *size = (size_t)(stop - (p + n + 2));
        return p + n + 2;
    }
    return 0;
}
/* True if a tag, which ends before `end`, begins with this text. */
static int demi_tag_is(const char *tag, const char *end, const char *begin) {
    const size_t n = strlen(begin);
    return (size_t)(end - tag) >= n && !memcmp(tag, begin, n);
}
/* True if a tag has an attribute of this name and value. */
static int demi_attribute_is(const char *tag, const char *end, const char *name,
                             const char *value) {
    size_t size = 0;
    const char *is = demi_attribute(tag, end, name, &size);
    return is && size == strlen(value) && !memcmp(is, value, size);
}
/* Returns the value of an attribute, an integer of at most 15 digits; -1 if it is none. */
static double demi_attribute_number(const char *tag, const char *end, const char *name) {
    size_t size = 0, i;
    const char *is = demi_attribute(tag, end, name, &size);
    double number = 0;
    if (!is || !size || size > 15) return -1;
    for (i = 0; i < size; i++) {
        if (is[i] < '0' || is[i] > '9') return -1;
        number = 10*number + (is[i] - '0');
    }
    return number;
}
/* A VTP or VTU file being read. */
typedef struct demi_vtp_in {
    const demi_text *t;
    demi_layout *l;
    dem_grains *g;
    const char *data, *end;        /* appended data, behind its underscore; null: there is none */
    int raw, wide, big;            /* 1: these are bytes, not base64; sizes have 8 bytes, not 4;
                                      big-endian */
    size_t points;                 /* in the piece being read */
} demi_vtp_in;
static dem_result demi_vtp_fail(const demi_vtp_in *v, const char *what) {
    return demi_fail(v->t->world, DEM_ERROR_FORMAT, "%s: %s: %s; give a VTP file whose data is "
                     "ascii, base64 or raw and not compressed (ParaView: CompressorType None), or "
                     "a CSV file", v->t->call, v->t->name, what);
}
/* Decodes base64 up to the first character that is neither base64 nor a blank. Returns the number
   of bytes. */
static size_t demi_base64(const char *from, const char *end, unsigned char *out) {
    static const char signs[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    uint32_t bits = 0;
    size_t n = 0;
    int have = 0;
    for (; from < end; from++) {
        const char *at = *from ? strchr(signs, *from) : 0;
        if (!at && strchr(" \t\r\n", *from) && *from) continue;
        if (!at) break;
        bits = bits << 6 | (uint32_t)(at - signs);
        have += 6;
        if (have < 8) continue;
        have -= 8;
        out[n++] = (unsigned char)(bits >> have);
    }
    return n;
}
/* Reads the array of a DataArray tag, which ends before `body`: text, base64, or appended data. */
static dem_result demi_vtp_array(const demi_vtp_in *v, const char *tag, const char *body,
                                 const char *name, size_t length, int width) {
    const int appended = demi_attribute_is(tag, body, "format", "appended");
    const size_t head = v->wide ? 8 : 4, n = v->points*(size_t)width;
    const char *end = v->t->end, *from = body;
    unsigned char *bytes = 0;
    demi_numbers in;
    demi_text words = *v->t;
    size_t size = 0;
    const char *type = demi_attribute(tag, body, "type", &size);
    dem_result result;
    memset(&in, 0, sizeof in);
    if (!type || !demi_numbers_type(&in, type, size))
        return demi_vtp_fail(v, "has an array whose type is not a number");
    if (appended) {
        const double offset = demi_attribute_number(tag, body, "offset");
        if (!v->data || offset < 0 || offset > (double)(v->end - v->data))
            return demi_vtp_fail(v, "is cut short, or has no appended data");
        from = v->data + (size_t)offset;
        end = v->end;
    } else {
        const char *stop = (const char *)memchr(body, '<', (size_t)(end - body));
        if (!stop) return demi_vtp_fail(v, "is cut short within an array");
        end = stop;
    }
    if (!appended && !demi_attribute_is(tag, body, "format", "binary")) {
        words.next = words.at = words.line_end = body;
        words.end = end;
        for (words.line = 1, from = words.data; from < body; from++) words.line += *from == '\n';
        words.line--;
        in.text = &words;
    } else if (!appended || !v->raw) {          /* decode no more than the array takes */
        const double most = ((double)n*in.size + (double)head + 3)*4/3;
        if (most > (double)(end - from) + 16)
            return demi_vtp_fail(v, "is cut short within an array");
        if (appended && most + 16 < (double)(end - from)) end = from + (size_t)most + 16;
        bytes = (unsigned char *)demi_alloc(v->t->world, (size_t)(end - from) + 1, 1);
        if (!bytes) return demi_text_memory(v->t);
        in.at = bytes;
        in.end = bytes + demi_base64(from, end, bytes);
    } else {
        in.at = (const unsigned char *)from;
        in.end = (const unsigned char *)end;
    }
    in.big = v->big;
    result = DEM_OK;
    if (!in.text) {
        const double says = (size_t)(in.end - in.at) < head ? -1 :
            demi_number_of(in.at, (int)head, 'u', in.big);
        if (says < (double)n*in.size || says > (double)n*in.size)
            result = demi_vtp_fail(v, "is cut short, or gives a wrong size for an array");
        else in.at += head;
    }
    if (result == DEM_OK)
        result = demi_array_read(v->t, &in, v->l, v->g, name, length, v->points, width, 1);
    demi_free(v->t->world, bytes);
    return result;
}
/* Reads the VTKFile tag (byte order, size of sizes, compression, which is an error) and finds the
   appended data. */
static dem_result demi_vtp_head(demi_vtp_in *v, const char *tag, const char *end) {
    size_t size = 0;
    const char *word = demi_attribute(tag, end, "compressor", &size);
    char what[120];
    if (word) {
        demi_words(what, sizeof what, "is compressed (%.*s)", (int)DEMI_MIN(size, 60), word);
        return demi_vtp_fail(v, what);
    }
    v->wide = demi_attribute_is(tag, end, "header_type", "UInt64");
    v->big = demi_attribute_is(tag, end, "byte_order", "BigEndian");
    for (word = end; (word = (const char *)memchr(word, '<', (size_t)(v->t->end - word))) != 0;
         word++) {
        const char *from;
        if (!demi_tag_is(word, v->t->end, "<AppendedData")) continue;
        from = (const char *)memchr(word, '>', (size_t)(v->t->end - word));
        if (!from) break;
        v->raw = demi_attribute_is(word, from, "encoding", "raw");
        v->data = (const char *)memchr(from, '_', (size_t)(v->t->end - from));
        v->end = v->t->end;
        if (v->data) v->data++;
        break;
    }
    return DEM_OK;
}
/* Reads grains from a VTP or VTU file with at most one piece that has points. */
static dem_result demi_grains_vtp(const demi_text *t, demi_layout *l, dem_grains *g) {
    const char *p = t->data, *end, *name;
    demi_vtp_in v = {t, l, g, 0, 0, 0, 0, 0, 0};
    dem_result result = DEM_OK;
    double number = -1, factor;
    size_t size = 0;
    int places = 0, arrays = 0, pieces = 0, heads = 0, width;
    for (; result == DEM_OK && (p = (const char *)memchr(p, '<', (size_t)(t->end - p))) != 0;
         p = end) {
        end = (const char *)memchr(p, '>', (size_t)(t->end - p));
        if (!end || demi_tag_is(p, end, "<AppendedData")) break;
        if (demi_tag_is(p, end, "<VTKFile") && !heads++) result = demi_vtp_head(&v, p, end);
        if (demi_tag_is(p, end, "<Piece")) {
            number = demi_attribute_number(p, end, "NumberOfPoints");
            if (number < 0 || number > INT_MAX/64)
                return demi_vtp_fail(&v, "has no number of points, or too many points");
            if (number > 0 && pieces++) return demi_vtp_fail(&v, "has more than one piece");
            if (number > 0 || !pieces) v.points = (size_t)number;
        }
        if (demi_tag_is(p, end, "<Points")) places = 1;
        if (demi_tag_is(p, end, "</Points")) places = 0;
        if (demi_tag_is(p, end, "<PointData")) arrays = end[-1] != '/';
        if (demi_tag_is(p, end, "</PointData")) arrays = 0;
        if (!demi_tag_is(p, end, "<DataArray") || !(places || arrays) || number <= 0 ||
            result != DEM_OK) continue;
        name = demi_attribute(p, end, "Name", &size);
        number = demi_attribute_number(p, end, "NumberOfComponents");
        width = number < 1 ? 1 : (int)DEMI_MIN(number, (int)DEMI_COLUMNS_MOST);
        number = (double)v.points;
        if (places) { name = "points"; size = 6; width = 3; }
        if (!name) continue;
        if (demi_column_of(name, size, 0, width, &factor) == DEMI_COLUMN_OTHER)
            demi_grains_ignore(g, name, size);
        else result = demi_vtp_array(&v, p, end + 1, name, size, width);
    }
    if (result != DEM_OK) return result;
    if (number < 0) return demi_vtp_fail(&v, "has no piece with points");
    return v.points ? demi_layout_check(t, l, g) : DEM_OK;
}

/* Reads grains from memory. The contents identify the format. call: the public function, for error
   messages. */
static dem_result demi_grains_parse(dem_world *w, const char *call, const char *name,
                                    const char *data, size_t size, dem_grains *g) {
    const int mark = size >= 3 && !memcmp(data, "\xEF\xBB\xBF", 3);     /* byte order mark */
    const int vtk = size >= 14 && !memcmp(data, "# vtk DataFile", 14);
    demi_text t = demi_text_make(w, call, name, data + 3*mark, size - 3*(size_t)mark);
    demi_layout layout;
    demi_text first = t;
    int32_t count = 0;
    dem_result result;
    memset(g, 0, sizeof *g);
    memset(&layout, 0, sizeof layout);
    demi_text_line(&first);
    if (vtk) result = demi_grains_vtk(&t, &layout, g);
    else if (first.length && *first.word == '<') result = demi_grains_vtp(&t, &layout, g);
    else if (memchr(data, 0, size))
        result = demi_fail(w, DEM_ERROR_FORMAT, "%s: %s: found bytes that are not text; give text, "
                           "CSV, XYZ, a LAMMPS or LIGGGHTS dump, VTK or VTP", call, t.name);
    else if (!first.length) result = demi_text_fail(&first, "grains are expected; is the file "
                                                    "empty?");
    else if (demi_text_is(&first, "item:")) result = demi_grains_dump(&first, &layout, g);
    else if (demi_text_integer(&first, first.length, &count) && count >= 0 &&
             (t = first, !demi_text_word(&t)))
        result = demi_grains_xyz(&first, count, &layout, g);
    else result = demi_grains_text(&first, &layout, g);
    if (result == DEM_OK && !g->count &&
        (!demi_grains_hold(w, g, DEMI_COLUMN_X, 0) || !demi_grains_hold(w, g, DEMI_COLUMN_R, 0)))
        result = demi_text_memory(&t);
    if (result != DEM_OK) demi_grains_free(w, g);
    return result;
}
DEM_API dem_result dem_grains_parse(dem_world *w, const char *name, const void *data, size_t size,
                                    dem_grains *g) {
    if (demi_null_write(w, __func__, g, "grains")) return DEM_ERROR_ARGUMENT;
    memset(g, 0, sizeof *g);
    if (demi_null_write(w, __func__, data, "data")) return DEM_ERROR_ARGUMENT;
    return demi_grains_parse(w, __func__, name, (const char *)data, size, g);
}
DEM_API dem_result dem_grains_read(dem_world *w, const char *path, dem_grains *g) {
    char *bytes = 0;
    size_t size = 0;
    dem_result result;
    if (demi_null_write(w, __func__, g, "grains")) return DEM_ERROR_ARGUMENT;
    memset(g, 0, sizeof *g);
    result = demi_load(w, __func__, path, &bytes, &size);
    if (result == DEM_OK)
        result = demi_grains_parse(w, __func__, path, bytes, size, g);
    demi_free(w, bytes);
    return result;
}
DEM_API void dem_grains_free(dem_world *w, dem_grains *g) {
    if (demi_null_look(w, __func__, g, "grains")) return;
    demi_grains_free(w, g);
}
DEM_API dem_result dem_grains_add(dem_world *w, dem_material material, const dem_grains *g) {
    int i, first;
    if (demi_null(w, __func__, g, "grains")) return DEM_ERROR_ARGUMENT;
    if (g->count < 0 || (g->count && (!g->positions || !g->radii)))
        return demi_refuse(w, __func__, "count is %d, or positions or radii are null; count must "
                           "be >= 0 with both arrays; pass what dem_grains_read filled in",
                           g->count);
    for (i = 0; i < g->count; i++) {
        dem_material m = material;
        int index = 0;
        if (!m.id && !g->materials)
            return demi_refuse(w, __func__, "material is null and the file names no materials; "
                               "pass an id that dem_material_add returned");
        if (!m.id) m.id = g->materials[i];
        if (demi_material_index(w, __func__, m, &index) != DEM_OK) return DEM_ERROR_ARGUMENT;
        if (demi_mass_refuse(w, __func__, index, -1, g->radii[i], i) ||
            demi_motion_refuse(w, __func__, i, i, g->positions, g->velocities, g->spins))
            return DEM_ERROR_ARGUMENT;
    }
    first = w->bodies.count;
    if (!demi_list_drop(w) ||
        !demi_bodies_reserve(w, (size_t)first + (size_t)DEMI_MAX(g->count, 0)))
        return demi_no_memory(w, __func__);
    for (i = 0; i < g->count; i++) {
        const int m = (material.id ? material.id : g->materials[i]) - 1;
        const uint32_t slot = demi_body_append(w, m, g->radii[i], demi_at(g->positions + 3*i));
        demi_body_start(w, w->bodies.slot_index[slot], g->velocities ? g->velocities + 3*i : 0,
                        g->spins ? g->spins + 3*i : 0, 0);
    }
    demi_scene_changed(w);
    demi_built(w, __func__);
    return DEM_OK;
}
