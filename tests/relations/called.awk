# awk -f tests/relations/called.awk dem.h tests/relations/*.h: prints the public functions that no file of relations
# calls. Texts and comments do not count.
FNR == 1 { file++; comment = 0 }
{
    s = $0
    gsub(/"([^"\\]|\\.)*"/, "", s)
    if (comment) { if (!sub(/^.*\*\//, "", s)) next; comment = 0 }
    while (match(s, /\/\*/)) {
        head = substr(s, 1, RSTART - 1); rest = substr(s, RSTART + 2)
        if ((end = index(rest, "*/")) > 0) s = head " " substr(rest, end + 2)
        else { s = head; comment = 1 }
    }
}
file == 1 && />>implementation - stop here/ { private = 1 }
file == 1 && !private && (/^DEM_API/ || /^DEM_INLINE/ || /^static inline/) && match(s, /dem_[a-z0-9_]+\(/) {
    name = substr(s, RSTART, RLENGTH - 1)
    if (!(name in public)) { public[name]; order[++count] = name }
}
file > 1 {
    while (match(s, /dem_[a-z0-9_]+\(/)) {
        called[substr(s, RSTART, RLENGTH - 1)]
        s = substr(s, RSTART + RLENGTH)
    }
}
END {
    for (k = 1; k <= count; k++) if (!(order[k] in called)) { print "relations never call " order[k]; bad++ }
    if (count < 150) { print "found only " count " public functions"; bad++ }
    if (!bad) print "relations call all " count " public functions"
    exit bad > 0
}
