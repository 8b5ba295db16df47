# awk -f tests/viewer.awk examples/replay/viewer.html dem.h: prints dem.h with the viewer of replays put between
# the lines "viewer: begin" and "viewer: end", as C strings; without indentation and lines that are comments.
# `make viewer` replaces dem.h by it, `make tags` tells when the two differ.
NR == FNR {
    sub(/^[ \t]+/, "")
    if ($0 == "" || $0 ~ /^\/\/ /) next
    for (i = 1; i <= length($0); i++) {
        c = substr($0, i, 1)
        add(c == "\\" || c == "\"" ? "\\" c : c == "?" && last == "?" ? "\\?" : c)
        last = c
    }
    add("\\n")
    last = ""
    next
}
/^\/\* viewer: end \*\/$/ { inside = 0 }
!inside { print }
/^\/\* viewer: begin \*\/$/ {
    inside = 1
    print "static const char *const demi_viewer[] = {"
    for (i = 1; i <= pieces; i++) printf "    \"%s\"%s\n", piece[i], i < pieces ? "," : "};"
}
function add(text) {                # an escape sequence stays whole
    if (!pieces || length(piece[pieces]) + length(text) > 93) pieces++
    piece[pieces] = piece[pieces] text
}
