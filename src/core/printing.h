/* ---------------------------------------------------------------------------------------------
   >>printing
   Formatted text with a decimal point in every locale: error messages, reports, progress lines.
   printf takes the decimal mark of the locale, which the program that includes dem.h may have set.
   Files are written by fprintf, with numbers from demi_format_real.
   Tests: tests/core/test_printing.c.
   --------------------------------------------------------------------------------------------- */
/* Where text goes: `file`, or if that is null `to`, which has room for `room` bytes. n: bytes so
   far, also those without room. */
typedef struct demi_ink { FILE *file; char *to; size_t room; int n; } demi_ink;
#define DEMI_INK(x) \
    o->n += o->file ? fprintf(o->file, how, x) \
        : snprintf(o->to + o->n, (size_t)o->n < o->room ? o->room - (size_t)o->n : 0, how, x)
/* Replaces the decimal mark of a printed number, of any length, by a point. Returns `text`. */
static const char *demi_pointed(char *text) {
    char *mark = text + strspn(text, " 0123456789+-.einfa");
    const size_t size = strcspn(mark, "0123456789e");
    if (size) {
        *mark = '.';
        memmove(mark + 1, mark + size, strlen(mark + size) + 1);
    }
    return text;
}
/* Prints a number with the format `how`, which has no other conversion. */
static void demi_ink_real(demi_ink *o, const char *how, double x) {
    char text[512];
    snprintf(text, sizeof text, how, x);
    demi_pointed(text);
    how = "%s";
    DEMI_INK(text);
}
/* Prints as vfprintf: the conversions d, i, u, x, c, s, e, f, g and %, the lengths l, ll and z,
   flags, and a width and precision, which may be *. */
static void demi_ink_all(demi_ink *o, const char *format, va_list args) DEMI_FORMAT(2, 0);
static void demi_ink_all(demi_ink *o, const char *format, va_list args) {
    char how[64];
    while (*format) {
        size_t n = 0, longs = 0, size = 0;
        if (*format != '%' || format[1] == '%') {
            const int plain = *format == '%' ? 1 : (int)strcspn(format, "%");
            const char *text = format;
            format += *format == '%' ? 2 : plain;
            if (o->file) o->n += fprintf(o->file, "%.*s", plain, text);
            else o->n += snprintf(o->to + o->n, (size_t)o->n < o->room
                                  ? o->room - (size_t)o->n : 0, "%.*s", plain, text);
            continue;
        }
        do {
            if (*format == '*') n += (size_t)snprintf(how + n, 12, "%d", va_arg(args, int));
            else how[n++] = *format;
            longs += *format == 'l';
            size += *format++ == 'z';
        } while (n < 50 && *format && !strchr("diuxcsefg", format[-1]));
        how[n] = 0;
        switch (format[-1]) {
        case 's': DEMI_INK(va_arg(args, const char *)); break;
        case 'e': case 'f': case 'g': demi_ink_real(o, how, va_arg(args, double)); break;
        case 'u': case 'x':
            if (size) DEMI_INK(va_arg(args, size_t));
            else if (longs > 1) DEMI_INK(va_arg(args, unsigned long long));
            else if (longs) DEMI_INK(va_arg(args, unsigned long));
            else DEMI_INK(va_arg(args, unsigned));
            break;
        default:
            if (longs > 1) DEMI_INK(va_arg(args, long long));
            else if (longs) DEMI_INK(va_arg(args, long));
            else DEMI_INK(va_arg(args, int));
        }
    }
}
/* Prints to a file, as fprintf. */
static void demi_print(FILE *file, const char *format, ...) DEMI_FORMAT(2, 3);
static void demi_print(FILE *file, const char *format, ...) {
    demi_ink o = {file, 0, 0, 0};
    va_list args;
    va_start(args, format);
    demi_ink_all(&o, format, args);
    va_end(args);
}
/* Prints to `to`, as vsnprintf and snprintf. Return the length of the whole text. */
static int demi_words_of(char *to, size_t room, const char *format, va_list args) DEMI_FORMAT(3, 0);
static int demi_words_of(char *to, size_t room, const char *format, va_list args) {
    demi_ink o = {0, to, room, 0};
    if (room) *to = 0;
    demi_ink_all(&o, format, args);
    return o.n;
}
static int demi_words(char *to, size_t room, const char *format, ...) DEMI_FORMAT(3, 4);
static int demi_words(char *to, size_t room, const char *format, ...) {
    va_list args;
    int n;
    va_start(args, format);
    n = demi_words_of(to, room, format, args);
    va_end(args);
    return n;
}
