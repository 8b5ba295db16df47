/* ---------------------------------------------------------------------------------------------
   >>stream
   A stream of bytes that a visit writes, reads, counts or hashes: one function serves a file, a
   copy in memory and a digest.
   --------------------------------------------------------------------------------------------- */
/* Where a visit writes to or reads from: `file`, or memory at `to`, or memory at `from`. If all
   three are null, the visit only counts bytes. */
typedef struct demi_stream {
    FILE *file;
    char *to;
    const char *from;
    uint64_t sum;                    /* hash of the bytes visited; 0 at the beginning: no hash */
    size_t size, left;               /* bytes visited; bytes that may still be read at `from` */
    int cut;                         /* 1: a read went beyond the last byte */
} demi_stream;

/* Writes `size` bytes of data, or reads them into data, as the stream says. A read beyond the end
   sets data to zeros. */
static void demi_visit(demi_stream *s, void *data, size_t size) {
    s->size += size;
    if (!size) return;
    if (s->sum) s->sum = demi_hash(s->sum, data, size);
    if (s->file) fwrite(data, 1, size, s->file);
    else if (s->to) {
        memcpy(s->to, data, size);
        s->to += size;
    } else if (s->from && size <= s->left) {
        memcpy(data, s->from, size);
        s->from += size;
        s->left -= size;
    } else if (s->from) {
        memset(data, 0, size);
        s->left = 0;
        s->cut = 1;
    }
}
#define DEMI_VISIT(s, value) demi_visit(s, &(value), sizeof(value))
/* --- reading a checkpoint: the reader, and the message that a value is impossible --- */

/* A checkpoint being read. */
typedef struct demi_reader {
    dem_world *w, *t;              /* the world; its twin */
    const char *path;
    demi_stream s;                 /* what is left of the file */
} demi_reader;

/* Fails with the message that a value is impossible although the checksum is correct. which: the
   index of its item, or -1. Returns 0. */
static int demi_lie(const demi_reader *r, const char *what, long long which) {
    char number[32] = "";
    if (which >= 0) demi_words(number, sizeof number, " %lld", which + 1);
    demi_fail(r->w, DEM_ERROR_FORMAT, "dem_checkpoint_read: %.200s: invalid %s%s, although the "
              "checksum is correct; the file was altered, or the run that wrote it had blown up: "
              "use an older checkpoint", r->path, what, number);
    return 0;
}
/* True if the rest of the file can hold so many items of `size` bytes. */
static int demi_left(const demi_reader *r, int64_t count, size_t size) {
    return count >= 0 && (uint64_t)count <= r->s.left/size;
}
/* True if x is finite and at least `least`. */
static int demi_sane(double x, double least) { return demi_finite_double(x) && x >= least; }
