# awk -f tests/refused.awk dem.h > tests/refused.h: a call of every public function that takes a world, for
# tests/api/test_refused.c, which has an argument of each type, good or bad. Of each desc also its fields, so that
# each is bad in turn. What is declared in a new type does not compile there: write good_TYPE or take_TYPE.
/>>implementation - stop here/ { exit }
{                                               # the line without comments
    line = ""; rest = $0
    while (rest != "") {
        at = index(rest, within ? "*/" : "/*")
        if (!within) line = line (at ? substr(rest, 1, at - 1) : rest)
        if (!at) break
        rest = substr(rest, at + 2); within = !within
    }
}
# the fields that DEM_LAW_COEFFICIENTS declares
line ~ /^#define DEM_LAW_COEFFICIENTS/ { listing = 1 }
listing && line ~ /^    X\(/ { property = line; sub(/^    X\(/, "", property); sub(/,.*/, "", property); properties = properties "dem_real " property "; " }
line !~ /\\ *$/ { listing = 0 }
line ~ /DEM_LAW_COEFFICIENTS\(DEM_PROPERTY_FIELD\)/ { line = properties }
# fields of structs, in order
line ~ /^typedef struct dem_[a-z_]+ \{/ { type = line; sub(/^typedef struct /, "", type); sub(/ \{.*/, "", type); sub(/^.*\{/, "", line); text = "" }
type != "" {
    text = text " " line
    if (line !~ /\}/) next
    sub(/\}.*/, "", text)
    count = split(text, item, ";")
    for (i = 1; i <= count; i++) {
        sub(/^ +/, "", item[i])
        if (item[i] == "" || item[i] ~ /\(/) continue
        pointer = item[i] ~ /\*/ || item[i] ~ /_fn /
        gsub(/const |unsigned |struct |\*/, "", item[i])
        kind = item[i]; sub(/ .*/, "", kind); names = item[i]; sub(/^[^ ]+ /, "", names)
        of = ""
        if (kind ~ /^(int|int32_t)$/ || (kind ~ /^dem_/ && !(kind in structs))) of = "INT"
        if (kind == "double") of = "DOUBLE"
        if (kind ~ /^dem_(real|vec3|quat|box)$/) of = "REAL"
        if (pointer) of = "POINTER"
        if (of == "") continue
        n = split(names, name, ",")
        for (k = 1; k <= n; k++) {
            gsub(/[ \[].*$/, "", name[k]); sub(/^ +/, "", name[k])
            if (name[k] == "") { split(names, again, ","); name[k] = again[k]; gsub(/ |\[.*/, "", name[k]) }
            rows[type] = rows[type] sprintf("    {\"%s\", \"%s\", offsetof(%s, %s), FIELD_%s, sizeof(((%s *)0)->%s)},\n", type, name[k], type, name[k], of, type, name[k])
        }
    }
    if (text !~ /^ *int32_t id; *$/ && type !~ /^dem_(vec3|quat|box)$/) structs[type] = 1
    type = ""
    next
}
# declarations
/^DEM_API/ { declaration = ""; declaring = 1 }
declaring {
    declaration = declaration " " line
    if (line !~ /;/) next
    declaring = 0
    gsub(/ +/, " ", declaration); sub(/^ DEM_API /, "", declaration)
    it = declaration; sub(/\(.*/, "", it); result = it; sub(/ ?\*?dem_[a-z0-9_]+$/, "", result); star = it ~ /\*/
    sub(/.*[ *]/, "", it)
    arguments = declaration; sub(/^[^(]*\(/, "", arguments); sub(/\)[^)]*$/, "", arguments)
    count = split(arguments, argument, ",")
    if (argument[1] !~ /dem_world \*world$/ || it == "dem_world_destroy") next
    calls[++all] = it
    looks = argument[1] ~ /^const/
    body = ""; list = "r->world"
    for (i = 2; i <= count; i++) {
        a = argument[i]; sub(/^ +/, "", a); sub(/\[[^\]]*\]$/, "", a); points = a ~ /\*/; constant = a ~ /^const /
        if (argument[i] ~ /\]$/) points = 1
        gsub(/const |struct /, "", a)
        word = a; sub(/.*[ *]/, "", word); kind = a; sub(/[ *].*/, "", kind)
        body = body "    " (constant ? "const " : "") kind " " (points ? "*" : "") word " = take_" (points ? (constant ? "const_" : "out_") : "") kind "(r, " i ", \"" word "\");\n"
        list = list ", " word
        if (points && kind ~ /^dem_/ && kind != "dem_real" && !((constant, kind) in asked)) {
            asked[constant, kind] = 1
            takes = takes (constant ? "TAKE_CONST(" : "TAKE_OUT(") kind ")\n"
            if (constant) rows_of[all] = rows_of[all] rows[kind]
        }
    }
    call = it "(" list ")"
    answer = "(void)" call ";\n    return 1"
    if (result == "void") answer = call ";\n    return 1"
    if (result == "dem_result") answer = "return " call " == DEM_OK"
    if (result == "int") answer = "return " call " > 0"
    if (result == "dem_body") answer = "return " call ".slot != 0"
    if (result ~ /^dem_(material|shape|wall|joint|feed|outlet|field|output)$/) answer = "return " call ".id != 0"
    if (it ~ /^dem_(mesh|profile|grains)_(read|parse)$/) {     # what a call that succeeds gives is freed
        kind = it; sub(/_[a-z]*$/, "", kind); out = kind; sub(/dem_/, "", out)
        answer = "const int good = " call " == DEM_OK;\n    if (good) " kind "_free(r->world, " out ");\n    return good"
    }
    if (star && it == "dem_slabs_create") answer = "return slabs_dropped(" call ")"
    if (star && it == "dem_replay_open") answer = "return replay_dropped(" call ")"
    text_of[all] = "static int call_" it "(refuser *r) {\n" body "    " answer ";\n}\n"
    looks_of[all] = looks
}
END {
    print "/* made from dem.h by tests/refused.awk */\nstatic const refused_field refused_fields[] = {"
    for (i = 1; i <= all; i++) printf "%s", rows_of[i]
    print "    {0, 0, 0, 0, 0}};\n" takes
    for (i = 1; i <= all; i++) print text_of[i]
    print "static const refused_call refused_calls[] = {"
    for (i = 1; i <= all; i++) printf "    {\"%s\", call_%s, %d},\n", calls[i], calls[i], looks_of[i]
    print "    {0, 0, 0}};"
}
