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
