# awk -f tests/plain.awk -f tests/storeys.awk src/dem.h: functions that checks of src/ share. src/dem.h must be the only
# file that a check is given.
# Returns the line without comments and texts. A comment may go on in the next line: `comment` is then 1.
function plain(line,   out, i) {
    gsub(/\\./, "", line); gsub(/"[^"]*"/, "\"\"", line)
    for (;;) {
        if (comment) { i = index(line, "*/"); if (!i) return out; line = substr(line, i + 2); comment = 0 }
        i = index(line, "/*"); if (!i) return out line
        out = out substr(line, 1, i - 1); line = substr(line, i + 2); comment = 1
    }
}
