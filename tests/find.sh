# sh tests/find.sh: docs/find.md has at least 60 rows, each names a function, and every call in it is a function of the
# public part of dem.h and has as many arguments as its declaration. The last line is "N passed, N failed".
awk '
function arguments(text,   i, c, depth, n) {        # of a call or declaration, from its opening bracket on
    depth = n = 0
    for (i = 1; i <= length(text); i++) {
        c = substr(text, i, 1)
        if (c == "(") depth++
        if (c == ")" && --depth == 0) break
        if (c == "," && depth == 1) n++
    }
    return substr(text, 2, i - 2) ~ /^ *(void)? *$/ ? 0 : n + 1
}
function check(right, text) { if (right) passed++; else { failed++; print "FAILED docs/find.md: " text } }
FILENAME == "dem.h" && /^#endif \/\* DEM_H \*\// { private = 1 }
FILENAME == "dem.h" && private { next }
FILENAME == "dem.h" {
    if (/^(DEM_API|DEM_INLINE|static inline) /) { declaration = ""; reading = 1 }
    if (!reading) next
    declaration = declaration " " $0
    if (!/[;{]/) next
    reading = 0
    if (match(declaration, /dem_[a-z0-9_]+\(/)) known[substr(declaration, RSTART, RLENGTH - 1)] = arguments(substr(declaration, RSTART + RLENGTH - 1))
    next
}
/^\| / && !/^\| task / {
    rows++; calls = 0; rest = $0
    while (match(rest, /`[^`]*`/)) {
        code = substr(rest, RSTART + 1, RLENGTH - 2); rest = substr(rest, RSTART + RLENGTH)
        while (match(code, /dem_[a-z0-9_]+\(?/)) {
            name = substr(code, RSTART, RLENGTH); code = substr(code, RSTART + RLENGTH)
            call = sub(/\($/, "", name)
            if (!call && !(name in known)) continue         # a type
            calls++
            check(name in known, name " is not in dem.h")
            if (call && name in known) {
                n = arguments("(" code)
                check(n == known[name], name " has " known[name] " arguments in dem.h, here " n)
            }
        }
    }
    check(calls > 0, "no function in: " $0)
}
END {
    check(rows >= 60, rows + 0 " rows, fewer than 60")
    print rows + 0 " tasks"
    print passed + 0 " passed, " failed + 0 " failed"
    exit failed > 0
}' dem.h docs/find.md
