# awk -v out=DIR -f bench/code.awk FILE...: writes code without comments and white space, so that its checksum changes only
# when the code does. dem.h is cut into its parts: DIR/>>near and so on; another file becomes DIR/NAME with % for each /.
#   dem.h       string constants that contain a blank are left out, too: no figure depends on the wording of a message
#   *.c, *.h    other C files keep their strings, which may be headings of a table
#   others      scripts: lines that begin with # are comments
BEGIN { dashes = "------------------------------------------------------------"; equals = dashes; gsub(/-/, "=", equals) }
FNR == 1 {
    finish()
    c = FILENAME ~ /\.[ch]$/; header = FILENAME ~ /(^|\/)dem\.h$/
    part = header ? ">>contents" : FILENAME
    comment = 0; ruled = 0
}
header {                                # as tests/tags.awk finds parts: a tag below a rule
    if (was_ruled && $1 ~ /^>>[a-z]/) { finish(); part = $1 }
    was_ruled = index($0, dashes) || index($0, equals)
}
c { add(bare($0)); next }
!/^[ \t]*#/ { add($0) }
END { finish() }

# a line of C without its comments
function bare(rest,   kept, mark, literal) {
    kept = ""
    while (rest != "") {
        if (comment) {
            if (!match(rest, /\*\//)) return kept
            rest = substr(rest, RSTART + 2); comment = 0
        }
        if (!match(rest, /"|'|\/\*|\/\//)) return kept rest
        kept = kept substr(rest, 1, RSTART - 1); rest = substr(rest, RSTART); mark = substr(rest, 1, 2)
        if (mark == "//") return kept
        if (mark == "/*") { comment = 1; rest = substr(rest, 3); continue }
        if (!match(rest, /^"([^"\\]|\\.)*"/) && !match(rest, /^'([^'\\]|\\.)*'/)) return kept rest
        literal = substr(rest, 1, RLENGTH); rest = substr(rest, RLENGTH + 1)
        kept = kept (header && literal ~ /^".* / && kept !~ /_Pragma *\($/ ? "\"\"" : literal)
    }
    return kept
}
function add(line) {
    gsub(/[ \t\r\f]/, "", line)
    if (header) {                       # a message that was broken in other places is the same message
        while (sub(/""""/, "\"\"", line)) continue
        if (message && line ~ /^""/) line = substr(line, 3)
        if (line != "") message = line ~ /""$/
    }
    text = text line
    if (length(text) > 4000) write()
}
function write(   name) {
    name = part; gsub(/\//, "%", name)
    printf "%s", text > (out "/" name)
    text = ""; begun = 1
}
function finish(   name) {
    if (part == "") return
    write()
    name = part; gsub(/\//, "%", name); close(out "/" name)
    text = ""; message = 0; part = ""
}
