# awk -f tests/plain.awk -f tests/storeys.awk src/dem.h: the rooms above the banner >>services are volume I of dem.h,
# those below it are volume II. No room of volume I may name what only volume II defines: a function, a macro, a type, a
# table or a constant. Comments and texts may. Each volume has a budget of lines; the public half and src/dem.h itself
# count to volume I. Prints both, and ends with code 1 if a name crosses or a budget is exceeded.
BEGIN { budget[1] = 35600; budget[2] = 11500; volume = 1 }
/^   >>services/ { volume = 2 }
/^#include "/ { split($0, part, "\""); room[++rooms] = part[2]; storey[rooms] = volume }
END {
    path = FILENAME; sub(/[^\/]*$/, "", path); lines[1] = FNR
    for (r = 1; r <= rooms; r++) read_room(r, 0)
    for (r = 1; r <= rooms; r++) if (storey[r] == 1 && room[r] !~ /^api\//) read_room(r, 1)
    for (v = 1; v <= 2; v++) {
        printf "volume %s: %d lines, at most %d\n", v == 1 ? "I" : "II", lines[v], budget[v]
        if (lines[v] > budget[v]) { print "src/: volume " v " has more lines than its budget (tests/storeys.awk)"; bad = 1 }
    }
    exit bad
}
function read_room(r, naming,   line, at, code) {
    while ((getline line < (path room[r])) > 0) {
        code = plain(line); at++
        if (naming) names(r, code, at)
        else { lines[storey[r]]++; definitions(r, code) }
    }
    close(path room[r])
    comment = listing = 0
}
function definitions(r, code,   name, ends) {
    name = code; ends = code ~ /}/
    if (code ~ /^DEM_API / && room[r] ~ /^api\//) name = ""   # declared only
    else if (code ~ /^(static|DEM_API|DEM_INLINE|DEMI_CLONES) /) { sub(/[(=;[{].*/, "", name); sub(/ +$/, "", name); sub(/.*[ *]/, "", name) }
    else if (code ~ /^# *define /) { sub(/^# *define +/, "", name); sub(/[^A-Za-z0-9_].*/, "", name) }
    else if (code ~ /^typedef (struct|enum|union) /) { sub(/^typedef [a-z]+ /, "", name); sub(/[^A-Za-z0-9_].*/, "", name) }
    else if (code ~ /^} [a-z0-9_]+;/) { sub(/^} /, "", name); sub(/;.*/, "", name) }
    else name = ""
    define(r, name)
    if (code ~ /^enum \{/) listing = 1
    if (!listing) return
    for (; match(code, /DEMI?_[A-Z0-9_]+( *=[^,}]*)?/); code = substr(code, RSTART + RLENGTH)) {
        name = substr(code, RSTART, RLENGTH); sub(/[^A-Z0-9_].*/, "", name); define(r, name)
    }
    if (ends) listing = 0
}
function define(r, name) {
    if (name !~ /^(dem|DEM)i?I?_/) return
    if (storey[r] == 1) { below[name] = 1; delete above[name] }
    else if (!(name in below)) above[name] = room[r]
}
function names(r, code, at,   name) {
    for (; match(code, /[A-Za-z0-9_]+/); code = substr(code, RSTART + RLENGTH)) {
        name = substr(code, RSTART, RLENGTH)
        if (name in above) { print "src/" room[r] ":" at ": " name " is of volume II (src/" above[name] "); volume I must not name it"; bad = 1 }
    }
}
