# Lists the fields of public descs that no row of calls.h names: awk -f fields.awk fields.txt dem.h calls.h. A field
# that no scene can have is a line of fields.txt, with the reason. Exit code 1: a field is in neither, or a line of
# fields.txt is not needed.
FILENAME ~ /fields\.txt$/ { if (NF && $1 !~ /^#/) { line = $0; sub(/^[^ ]+ +/, "", line); why[$1] = line }; next }
FILENAME ~ /dem\.h$/ {
    if ($0 ~ /^#define DEM_LAW_COEFFICIENTS/) { coefficients = 1; next }
    if (coefficients && match($0, /X\([a-z_]+/)) { property = substr($0, RSTART + 2, RLENGTH - 2); coefficients = 0 }
    if (match($0, /^typedef struct dem_[a-z_]+ \{/)) { struct = $3; body = ""; open = 1; sub(/.*\{/, "") }
    if (!open) next
    text = $0
    while (match(text, /\/\*[^*]*\*\//)) text = substr(text, 1, RSTART - 1) substr(text, RSTART + RLENGTH)
    if (comment) { if (text !~ /\*\//) next; sub(/^.*\*\//, "", text); comment = 0 }
    if (match(text, /\/\*/)) { text = substr(text, 1, RSTART - 1); comment = 1 }
    end = text ~ /\}/
    sub(/\}.*/, "", text)
    body = body " " text
    if (!end) next
    open = 0
    gsub(/DEM_LAW_COEFFICIENTS\([A-Z_]+\)/, "dem_real " property ";", body)
    n = split(body, part, ";")
    for (i = 1; i <= n; i++) {
        sub(/^[ \t]*(const )?(struct )?[a-z_0-9]+[ \t]+/, "", part[i])
        m = split(part[i], name, ",")
        for (k = 1; k <= m; k++) {
            gsub(/[ \t*]/, "", name[k]); sub(/\[.*/, "", name[k])
            if (name[k] != "") fields[struct] = fields[struct] " " name[k]
        }
    }
    next
}
{ # calls.h: the members of structs of arguments, then the rows
    if (match($0, /^typedef struct rel_a_[a-z_]+ \{/)) { of = $3 }
    if (of != "") {
        n = split($0, part, /[;{]/)
        for (i = 1; i <= n; i++)
            if (match(part[i], /dem_[a-z_0-9]+ [a-z, ]+$/)) {
                k = split(substr(part[i], RSTART, RLENGTH), word, /[ ,]+/)
                for (j = 2; j <= k; j++) type[of, word[j]] = word[1]
            }
        if ($0 ~ /\}/) of = ""
    }
    text = $0
    while (match(text, /F[INW]?(REF)?\((rel_a_[a-z_]+, )?[a-z]+\.[a-z_.]+/)) {
        row = substr(text, RSTART, RLENGTH)
        text = substr(text, RSTART + RLENGTH)
        in_wall = row ~ /^FW/
        sub(/^[A-Z]+\(/, "", row)
        if (in_wall) row = "rel_a_wall, " row
        split(row, half, ", ")
        member = half[2]; sub(/\..*/, "", member)
        field = half[2]; sub(/^[a-z]+\./, "", field); sub(/\..*/, "", field)
        set[type[half[1], member], field] = 1
    }
}
END {
    for (s in fields) {
        if (s !~ /_desc$/ && s !~ /^dem_(pair|motion|motion_row|sizes|selection|region|mesh|profile)$/) continue
        n = split(fields[s], f, " ")
        for (i = 1; i <= n; i++) {
            key = s "." f[i]
            count++
            if ((s, f[i]) in set) { if (key in why) { print "fields.txt: " key " has a row"; bad = 1 }; continue }
            if (key in why) { used[key] = 1; reasons++; continue }
            if ((s ".*") in why) { used[s ".*"] = 1; reasons++; continue }
            print key ": no row of calls.h names it"; bad = 1
        }
    }
    for (key in why) if (!(key in used)) { print "fields.txt: " key " is no field without a row"; bad = 1 }
    if (count < 200) { print "fields.awk: only " count " fields found"; bad = 1 }
    print count " fields, " reasons " without a row by fields.txt"
    exit bad
}
