# awk -f tests/upgrade/rows.awk examples/upgrade.txt NOW OLD: NOW are the public names of the present dem.h, OLD those
# of a former version (tests/upgrade/names.awk). Lists names of OLD that are neither in NOW nor in a row, fields and
# functions with other arguments likewise, rows that would rewrite present names, and rows whose new name does not
# exist.
FNR == 1 { part_of++ }
{ sub(/\r$/, "") }
part_of == 1 {
    if (/^[ \t]*(#|$)/) next
    while (sub(/ *\\$/, "") && (getline more) > 0) { sub(/^[ \t]*/, " ", more); $0 = $0 more }
    sub(/ :: .*/, "")
    if ($1 == "call") {
        line = $0; sub(/^call +/, "", line)
        name = line; sub(/\(.*/, "", name); has_call[name]; row[name]
        if ((at = index(line, "=>")) > 0) {
            line = substr(line, at + 2)
            while (match(line, /(dem|DEM)_[A-Za-z0-9_]+/)) {
                target[substr(line, RSTART, RLENGTH)]; line = substr(line, RSTART + RLENGTH)
            }
        }
    } else if ($1 == "name") { row[$2]; to[$2] = $3; renames[$2]; if ($3 ~ /^(dem|DEM)_/) target[$3] }
    else if ($1 == "gone") { row[$2]; renames[$2] }
    else if ($1 == "field") { field[$2 "." $3]; fields[++count] = $2 " " $3 " " $4 }
    next
}
part_of == 2 { now[$1]; next }
{ old[$1] }
function wrong(s) { print s; bad++ }
function new_struct(s) { return s in to ? to[s] : s }
END {
    for (name in old) {
        if (name in now) continue
        if (name ~ /\)$/) {                       # FUNCTION(N)
            sub(/\(.*/, "", name)
            if ((name in now) && !(name in has_call)) wrong(name ": has other arguments now; add a row `call`")
            if (!(name in now) && (name in to) && !(name in has_call)) moved[name]
        } else if (name !~ /\./) { if (!(name in row)) wrong(name ": is gone; add a row `name`, `call` or `gone`") }
        else {
            split(name, part, ".")
            if ((name in field) || (new_struct(part[1]) "." part[2]) in now) continue
            if ((new_struct(part[1]) "." part[2]) in field) continue
            if (!(part[1] in now) && !(part[1] in to)) { if (part[1] in row) continue }
            if (part[1] in to && to[part[1]] !~ /^dem_/) continue
            wrong(name ": is gone; add a row `field`")
        }
    }
    for (name in old) if (name ~ /\)$/) {         # a function that was only renamed takes as many arguments
        n = name; sub(/\(.*/, "", n); arity = substr(name, length(n) + 1)
        if ((n in moved) && to[n] ~ /^dem_/ && !((to[n] arity) in now))
            wrong(n ": " to[n] " has other arguments; replace `name` by a row `call`")
    }
    for (name in renames) if (name in now) wrong(name ": is a name of the present dem.h, so a row must not rename it")
    for (name in target) {
        if (!(name in now)) wrong(name ": is the new name of a row, but not a name of dem.h")
        if (name in renames) wrong(name ": is both an old and a new name")
    }
    for (i = 1; i <= count; i++) {
        split(fields[i], part, " ")
        if (part[3] == "") continue
        first = part[3]; sub(/[.[].*/, "", first)
        if (!((new_struct(part[1]) "." first) in now))
            wrong(part[1] "." part[2] ": its new name ." part[3] " is no field of " new_struct(part[1]))
        if (first != part[2] && (part[1] "." first) in field)
            wrong(part[1] "." first ": is both an old and a new field")
        if (first != part[2] && (new_struct(part[1]) "." part[2]) in now)
            wrong(part[1] "." part[2] ": is a field of the present dem.h")
    }
    exit bad > 0
}
