# awk -f tests/plain.awk -f tests/writers.awk src/dem.h: fields of the world that more than three rooms write. A field
# is a member of struct dem_world or of a struct in it (stage.dt_valid). A room is a file in src/ outside src/api; it
# writes a field if it assigns it (=, +=, ++ and so on) through a pointer to a world, or through a pointer that the
# same function has set to a struct in the world (demi_events *e = &w->events). An element counts for its field if the
# array lies in the world (booked.energy[k]). It does not count if the field points to an array: that is data, such as
# positions, on which many rooms work. An inline function counts for the room that defines it. Macros and functions
# that get the address of a field, such as DEMI_GROW and memset, do not count. Prints these fields with their rooms, and
# ends with code 1 if there are more than `cap`.
BEGIN { cap = 4; most = 3; assigned = "( *([-+*/|&^]|<<|>>)?=[^=]|\\+\\+|--)" }
/^#include "/ { split($0, part, "\""); if (part[2] !~ /^api\//) room[++rooms] = part[2] }
END {
    path = FILENAME; sub(/[^\/]*$/, "", path)
    for (pass = 1; pass <= 2; pass++) for (r = 1; r <= rooms; r++) read_room(r)
    for (f in by) if (writers[f] > most) { printf "%s: %d rooms:%s\n", f, writers[f], by[f] | "sort"; count++ }
    close("sort")
    printf "fields of the world written by more than three rooms: %d, at most %d\n", count, cap
    exit count > cap
}
# pass 1: members of structs, which may be pointers to worlds, or arrays; pass 2: writes
function read_room(r,   line, inner) {
    while ((getline line < (path room[r])) > 0) {
        line = plain(line)
        if (line ~ /^[a-zA-Z]/) {
            in_struct = line ~ /^(typedef )?struct [a-z_]+ [{]/
            split("", local); split("", within)
        }
        for (; match(line, /\[[^][]*\]/); line = substr(line, 1, RSTART - 1) "#" substr(line, RSTART + RLENGTH)) {
            inner = substr(line, RSTART + 1, RLENGTH - 2)
            if (pass == 2 && inner ~ /->/) { writes(r, inner); match(line, /\[[^][]*\]/) }
        }
        if (in_struct) members(line); else pointers(line)
        if (pass == 2) writes(r, line)
    }
    close(path room[r]); comment = 0
}
# # stands for a subscript
function members(line,   name) {
    if (line ~ /dem_world \*/) pointers(line)
    for (; match(line, /(^|[^*a-z0-9_])[a-z0-9_]+#/); line = substr(line, RSTART + RLENGTH)) {
        name = substr(line, RSTART, RLENGTH - 1); sub(/^[^a-z0-9_]/, "", name); array[name] = 1
    }
}
# notes the names of pointers to worlds, and to structs in a world, that the line declares
function pointers(line,   at, name, of, n, list) {
    at = line
    while (match(at, /dem_world \*+(const )?[a-z0-9_]+(( = [^,;]*)?, \*+[a-z0-9_]+)*/)) {
        name = substr(at, RSTART + 10, RLENGTH - 10); at = substr(at, RSTART + RLENGTH)
        gsub(/= [^,;]*|const |[*,]/, "", name)
        for (n = split(name, list, " "); n > 0; n--) if (in_struct) member[list[n]] = 1; else local[list[n]] = 1
    }
    for (at = line; match(at, /demi?_[a-z0-9_]+ \*(const )?[a-z0-9_]+ = &[a-z0-9_>.#-]+[;,]/);) {
        name = of = substr(at, RSTART, RLENGTH - 1); at = substr(at, RSTART + RLENGTH)
        sub(/.*&/, "", of); sub(/ =.*/, "", name); sub(/.*[* ]/, "", name)
        if (whole(of)) { sub(/.*->/, "", of); within[name] = of }
    }
}
# true if `of`, a path of pointers, points to a world until its last arrow
function whole(of,   reached) {
    sub(/->[^>]*$/, "", of); reached = of ~ /->|\./; gsub(/#/, "", of); sub(/.*(>|\.)/, "", of)
    return reached ? of in member : of in local
}
function writes(r, line,   of, name) {
    while (match(line, "[a-z0-9_>.#-]+->[a-z0-9_.#]+" assigned)) {
        of = name = substr(line, RSTART, RLENGTH); line = substr(line, RSTART + RLENGTH - 1)
        sub(assigned, "", of); sub(assigned, "", name); sub(/.*->/, "", name)
        if (!whole(of)) { sub(/->[^>]*$/, "", of); if (of in within) name = within[of] "." name; else name = "" }
        name = element(name)
        if (name != "" && !((name, r) in seen)) { seen[name, r] = 1; writers[name]++; by[name] = by[name] " " room[r] }
    }
}
# the field without subscripts, or nothing if it is an element of an array outside the world
function element(name,   of) {
    while (name ~ /#/) {
        of = name; sub(/#.*/, "", of); sub(/.*\./, "", of)
        if (!(of in array)) return ""
        sub(/#/, "", name)
    }
    return name
}
