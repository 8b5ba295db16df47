# cc -E -dD dem.h | awk -f tests/upgrade/names.awk | LC_ALL=C sort -u: the public names of dem.h, one per line:
# functions, types, constants and macros, STRUCT.FIELD for the fields of structs, and FUNCTION(N) with the number of
# arguments.
/^# [0-9]+ "/ { ours = $3 ~ /dem[a-z_0-9]*\.h"$/; next }
!ours { next }
/^#define (dem_|DEM_)/ { name = $2; sub(/\(.*/, "", name); print name }
/^#/ { next }
{ text = text " " $0 }
END {
    while ((at = index(text, "__attribute__((")) > 0)
        text = substr(text, 1, at - 1) substr(text, at + index(substr(text, at), "))") + 1)
    gsub(/"([^"\\]|\\.)*"/, "", text); gsub(/[ \t\r]+/, " ", text)
    while (match(text, /[;{}]/)) {
        piece = substr(text, 1, RSTART - 1); mark = substr(text, RSTART, 1); text = substr(text, RSTART + 1)
        if (mark == "{") {
            kind[++depth] = "body"
            if (piece ~ /enum( [a-z_]+)? *$/) kind[depth] = "enum"
            else if (piece ~ /(struct|union)( [a-z_]+)? *$/) kind[depth] = "struct"
            else if (depth == 1) declared(piece)
            path[depth] = kind[depth - 1] == "struct" ? path[depth - 1] : last(piece)
            if (kind[depth] != "body" && path[depth] ~ /^dem_/) print path[depth]
        } else if (mark == "}") {
            if (kind[depth] == "enum") constants(piece)
            closed = kind[depth--] != "body"
            continue
        } else if (kind[depth] == "struct") fields(piece, path[depth])
        else if (depth == 0 && !closed) declared(piece)
        else if (depth == 0 && last(piece) ~ /^dem_/) print last(piece)      # } NAME;
        closed = 0
    }
}
function last(s) { gsub(/\[[^]]*\]/, "", s); sub(/ +$/, "", s); sub(/.*[^A-Za-z0-9_]/, "", s); return s }
function constants(s,    part, n, i) {
    n = split(s, part, ",")
    for (i = 1; i <= n; i++) { sub(/=.*/, "", part[i]); if (last(part[i]) ~ /^DEM_/) print last(part[i]) }
}
function fields(s, of,    part, n, i) {
    if (of !~ /^dem_/) return
    if (match(s, /\(\*[a-z_]+\)/)) { print of "." substr(s, RSTART + 2, RLENGTH - 3); return }
    n = split(s, part, ",")
    for (i = 1; i <= n; i++) if (last(part[i]) != "") print of "." last(part[i])
}
function declared(s,    list, n) {
    if (match(s, /\(\*dem_[a-z_]+\)/)) { print substr(s, RSTART + 2, RLENGTH - 3); return }
    sub(/=.*/, "", s)
    list = s; sub(/^[^(]*\(/, "", list); sub(/\) *$/, "", list)
    n = s !~ /\(/ ? -1 : list ~ /^ *(void)? *$/ ? 0 : 1
    while (sub(/\([^()]*\)/, "", list)) { }
    n += gsub(/,/, "", list)
    sub(/\(.*/, "", s)
    if (last(s) !~ /^(dem|DEM)_/) return
    print last(s)
    if (n >= 0) print last(s) "(" n ")"
}
