# build/options | awk -f tests/options.awk - dem.h > docs/options.md: all options of a scene; with -v part=run those of a
# run, docs/options_run.md. Name and type of a field, its unit, what 0 means and the sentence about it are those of its
# declaration in dem.h. Range and values are those that dem.h checks (the rows that tests/options.c prints). Fails if a
# comment and a row differ in unit, range or `required`, or an enum and its row in the values.
#   comment of a field:  UNIT, required, RANGE: meaning; 0 means ...     each part may be absent
BEGIN { FS = "\t" }
FILENAME == "-" {
    if (!(($1, $2) in has)) {
        gsub(/e\+0?/, "e"); has[$1, $2] = 1; unit_of[$1, $2] = $3; range_of[$1, $2] = $4; least_of[$1, $2] = $5; words_of[$1, $2] = $6
        must[$1, $2] = $7; scene_of[$1, $2] = $8
        rows[$1]++; in_scene[$1] += $8
    }
    next
}
/^ *>>api$/ { begun = 1 }
begun && />>implementation - / { ended = 1 }
ended { next }
# --- the declarations of dem.h: head[], body[] of a type in the order of list[], constant[] and calls[] of a desc
/^   >>run$/ { running = 1 }
/^\/\*/ && !inside { comment = ""; talking = 1 }
talking { comment = comment " " $0; if (/\*\/ *$/) talking = 0; next }
/^(typedef )?(struct|enum) dem_[a-z_]+ \{/ {
    name = $0; sub(/^(typedef )?(struct|enum) /, "", name); sub(/ .*/, "", name)
    list[++types] = name; from_run[name] = running; is_enum[name] = /^typedef enum/; head[name] = clean(comment); body[name] = ""; comment = ""
    inside = 1; sub(/^[^{]*\{/, "")
}
inside && /DEM_LAW_COEFFICIENTS\(DEM_PROPERTY_FIELD\)/ {      # one field, named at the beginning of its comment
    at = 0; while (at + match(substr(body[name], at + 1), /\/\* [a-z_]+: /) > at) { from = at + RSTART; size = RLENGTH; at = from }
    word = substr(body[name], from + 3, size - 5)
    body[name] = substr(body[name], 1, from + 2) substr(body[name], from + size)
    $0 = "    dem_real " word ";"
}
inside { body[name] = body[name] "\n" $0; if (/^\}/ || /\} dem_[a-z_]+;/) { inside = 0; sub(/\}[^}]*$/, "", body[name]) } next }
/^static const dem_[a-z_]+ DEM_[A-Z_]+_ZERO/ { split($0, w, " "); constant[w[3]] = w[4]; sub(/_ZERO$/, "", constant[w[3]]) }
/^(DEM_API|static inline) / { proto = ""; reading = 1 }
reading {
    proto = proto " " $0
    if (!/[;{]/) next
    reading = 0
    if (!match(proto, /dem_[a-z_]+\(/)) next
    call = substr(proto, RSTART, RLENGTH - 1); rest = substr(proto, RSTART + RLENGTH)
    while (match(rest, /(const dem_[a-z_]+ \*|dem_[a-z_]+ )[a-z]+[,)]/)) {
        what = substr(rest, RSTART, RLENGTH); rest = substr(rest, RSTART + RLENGTH)
        sub(/^const /, "", what); sub(/ .*/, "", what)
        if (call !~ /_(error|checked)(_get)?$/ && !seen[what, call]++) calls[what] = calls[what] (calls[what] ? ", " : "") "`" call "`"
    }
}
END {
    title = part == "run" ? "Options of a run" : "Options of a scene"
    for (t = 1; t <= types; t++) if (!is_enum[list[t]] && (list[t] in constant || rows[list[t]]) && (part == "run") == from_run[list[t]]) shown[++many] = list[t]
    print "# " title "\n"
    print "Every field of every desc of " (part == "run" ? "a run: trials, measurements, replays, outputs, slabs. [options.md](options.md) has those of a scene." : "a scene, from the world to its outlets. [options_run.md](options_run.md) has those of a run.")
    for (t = 1; t <= many; t++) printf "%s", (t > 1 ? ", " : "") "[" shown[t] "](#" shown[t] ")"
    print ".\n\n`make options` makes this page from [dem.h](../dem.h). Units, defaults and meanings are those of the comments there, which"
    print "say more; ranges are those that dem.h checks. Fields that share a line share their meaning."
    print "\nStart from the constant of a desc, in which every field is 0, and set what differs. The column \"0 means\" gives the default"
    print "of a field (of a pointer or an id: what it means that there is none), or says that the field is required. It is empty"
    print "where 0 is an ordinary value or \"no\". A checkpoint can be read only by a world with the same scene; the text above each table"
    print "says which fields are part of the scene."
    for (t = 1; t <= many; t++) desc(shown[t])
    exit faults > 0
}
function fault(text) { print "options.awk: " text > "/dev/stderr"; faults++ }
function clean(text) {
    gsub(/[ \n]+/, " ", text); sub(/^ *\/\* */, "", text); sub(/ *\*\/ *$/, "", text)
    return text
}
# The declarations of a struct: names[1..n], type[], comments before[] and after[], heading[] (a comment before those).
function fields(name,   s, end, new, d, c, pending) {
    s = body[name]; n = 0; pending = ""
    split("", names); split("", type); split("", before); split("", after); split("", heading)
    for (;;) {
        match(s, /^[ \n]*/); new = index(substr(s, 1, RLENGTH), "\n") > 0; s = substr(s, RLENGTH + 1)
        if (s == "") break
        if (substr(s, 1, 2) == "/*") {
            end = index(s, "*/"); c = clean(substr(s, 1, end + 1)); s = substr(s, end + 2)
            if (!new && n && after[n] == "") after[n] = c
            else { if (pending != "") heading[n + 1] = pending; pending = c }
            continue
        }
        end = index(s, ";"); d = substr(s, 1, end - 1); s = substr(s, end + 1)
        n++; before[n] = pending; pending = ""
        gsub(/[ \n]+/, " ", d); sub(/^const /, "", d); sub(/^struct /, "", d)
        if (match(d, /\(\*[a-z_]+\)/)) { names[n] = substr(d, RSTART + 2, RLENGTH - 3); type[n] = "function"; continue }
        type[n] = d; sub(/ .*/, "", type[n]); sub(/^[^ ]* /, "", d)
        if (d ~ /^\*/) type[n] = type[n] " *"
        if (match(d, /\[[A-Z_0-9a-z]+\]/)) type[n] = type[n] substr(d, RSTART, RLENGTH)
        gsub(/[* ]|\[[A-Z_0-9a-z]+\]/, "", d); names[n] = d
    }
}
# The constants of an enum as a cell, and as the words of a row in `constants_as_words`.
function values(e,   s, k, m, part, name, prefix, out) {
    s = body[e]; gsub(/\n/, " ", s)
    while (match(s, /\/\*([^*]|\*[^\/])*\*\//)) s = substr(s, 1, RSTART - 1) substr(s, RSTART + RLENGTH)
    gsub(/ |= *[0-9]+/, "", s); m = split(s, name, ",")
    prefix = name[1]
    for (k = 2; k <= m; k++) while (index(name[k], prefix) != 1) prefix = substr(prefix, 1, length(prefix) - 1)
    sub(/[^_]*$/, "", prefix)
    constants_as_words = ""
    for (k = 1; k <= m; k++) {
        part = substr(name[k], length(prefix) + 1)
        constants_as_words = constants_as_words (k > 1 ? " " : "") tolower(part)
        out = out (k > 1 ? ", " : "`" prefix "`: ") "`" part "`"
    }
    first_constant = "`" substr(name[1], length(prefix) + 1) "`"
    return out
}
function cell(text) {
    if (text ~ /^[A-Z][a-z ]/ && text !~ /^(Weibull|Coulomb|Hertz|Young)/) text = tolower(substr(text, 1, 1)) substr(text, 2)
    gsub(/ \(>>[a-z]+\)/, "", text); gsub(/\*/, "\\*", text); gsub(/\|/, "\\|", text)
    gsub(/DEM_[A-Z_0-9]+|dem_[a-z_]+/, "`&`", text); gsub(/``/, "`", text)
    gsub(/>=/, "≥", text); gsub(/<=/, "≤", text)
    return text
}
function sentence(text) {                           # the first one
    if (match(text, /[^;,]\. [A-Z0-9`a-z]/)) return substr(text, 1, RSTART)
    sub(/\.$/, "", text)
    return text
}
# Takes UNIT, required, RANGE and what 0 means out of a comment, into unit, zero, range; what is left is the meaning.
function take(text, of,   rest, end, found) {
    unit = zero = range = ""
    if (of != "" && index(text, of) == 1 && substr(text, length(of) + 1) ~ /^([,;.:]|$)/) { unit = of; text = substr(text, length(of) + 1) }
    else if (match(text, /^(m|m\/s2?|m2\/s2|m3|m5|kg|kg\/m3|s|1\/s|Pa|N|N\/m|N m|N s\/m|m\/N|rad|rad\/s|Hz)([,;.:]|$)/)) {
        unit = substr(text, 1, RLENGTH); sub(/[,;.:]$/, "", unit); text = substr(text, length(unit) + 1)
    }
    text = "; " substr(text, unit == "" || text ~ /^[,;.:]/ ? 1 : 2)
    if (text ~ /^; [,;.:]? ?[Rr]equired([,;.:]|$)/) { sub(/^; [,;.:]? ?[Rr]equired/, ";", text); zero = "required" }
    if (match(sentence(text), /[,;.] ((> [0-9.]+|>= [0-9a-z_]+)( and <=? [0-9.e]+)?|[0-9.e-]+ to [0-9a-z_\/.]+|0 or >= [a-z_]+|at most [0-9.e]+ in size)([,;:]|$)/)) {
        found = RSTART; range = substr(text, RSTART + 2, RLENGTH - 2); sub(/[,;:]$/, "", range)
        text = substr(text, 1, found - 1) substr(text, found + 2 + length(range))
    }
    if (match(text, /[;,.] ([a-z_]+ )?(0|[Nn]ull) means (that )?/)) {
        found = substr(text, RSTART + 2, RLENGTH - 2); rest = substr(text, RSTART + RLENGTH); text = substr(text, 1, RSTART - 1)
        sub(/ ?(0|[Nn]ull) means .*/, "", found); if (found == "id") found = ""
        end = match(rest, /[;.] /) ? RSTART : length(rest) + 1
        zero = zero (zero ? "; 0: " : "") (found ? found ": " : "") substr(rest, 1, end - 1)
        sub(/\.$/, "", zero)
        text = text substr(rest, end)
    }
    sub(/^[ ;,.:]+/, "", text); sub(/[ ;,.:]+$/, "", text)
    return text
}
# The table of a desc.
function desc(d,   k, j, m, one, text, known, units, not_scene, only_scene, used, v, meant) {
    fields(d)
    lines = 0
    for (k = 1; k <= n; k++) {
        text = after[k] != "" ? after[k] : before[k] ~ /^--/ ? "" : before[k]
        title = heading[k] != "" ? heading[k] : after[k] != "" || before[k] ~ /^--/ ? before[k] : ""
        gsub(/^-- |: see "choices" above| --$/, "", title); sub(/\.$/, "", title)
        if (title != "") { lines++; row_name[lines] = ""; row[lines] = "| **" cell(title) "** | | | | | |" }
        m = split(names[k], one, ",")
        known = 0; units = ""; r = ""; least = ""; required = 0
        for (j = 1; j <= m; j++) {
            if (!((d, one[j]) in has)) continue
            known++
            if (unit_of[d, one[j]] != "" && index(", " units ",", ", " unit_of[d, one[j]] ",") == 0) units = units (units ? ", " : "") unit_of[d, one[j]]
            if (range_of[d, one[j]] != "" && r != range_of[d, one[j]]) r = r (r ? "; " : "") range_of[d, one[j]]
            least = least_of[d, one[j]]; required = must[d, one[j]]
            used[d, one[j]] = 1
            if (in_scene[d] && !scene_of[d, one[j]]) not_scene = not_scene (not_scene ? ", " : "") "`" one[j] "`"
            if (scene_of[d, one[j]]) only_scene = only_scene (only_scene ? ", " : "") "`" one[j] "`"
        }
        # a pointer that is passed on, and fields that share the comment of those before them, join their line
        base = type[k]; sub(/[[ ].*/, "", base)
        if (lines && row_name[lines] != "" && ((base == "void" && text ~ /^passed to/) || (text == "" && !is_enum[base] && shared))) {
            row_name[lines] = row_name[lines] "," names[k]
            if (index(row[lines], "`" type[k] "`") == 0) sub(/` \|/, "`, `" type[k] "` |", row[lines])
            continue
        }
        shared = after[k] == "" && before[k] != "" && before[k] !~ /^--/
        meant = take(text, units)
        if (units != "" && unit != units) fault(d "." names[k] " has the unit " units " in its row, and the comment \"" text "\"")
        r = r == "" ? range : r
        if (range != "" && range != r && range != least && r != "0 or " range) fault(d "." names[k] " has the range " r " in its row, and the comment \"" text "\"")
        if (required && zero !~ /^required/) fault(d "." names[k] " must be set, and its comment does not begin with: required")
        if (is_enum[base]) {
            v = values(base)
            if (known && words_of[d, one[1]] != "" && words_of[d, one[1]] != constants_as_words) fault(d "." names[k] " has the words \"" words_of[d, one[1]] "\" in its row, and the constants \"" constants_as_words "\"")
            r = v
            if (zero == "") zero = first_constant
            if (meant == "") meant = head[base]
        } else {
            sub(/ and /, ", ", r); sub(/^at most /, "± ", r); sub(/ in size$/, "", r)
            r = cell(r)
        }
        lines++; row_name[lines] = names[k]
        row[lines] = " | `" type[k] "` | " unit " | " r " | " cell(zero) " | " cell(sentence(meant)) " |"
    }
    for (k in has) { split(k, one, SUBSEP); if (one[1] == d && !((d, one[2]) in used)) fault(d " has a row for " one[2] ", which is no field") }
    print "\n## " d "\n"
    text = cell(sentence(head[d])) "."
    text = toupper(substr(text, 1, 1)) substr(text, 2)
    if (d in constant) text = text " Constant: `" constant[d] "`."
    if (calls[d]) text = text " Used by " calls[d] "."
    if (in_scene[d]) text = text " Part of the scene: " (length(only_scene) < length(not_scene) ? only_scene : "every field" (not_scene ? " except " not_scene : "")) "."
    print text "\n"
    print "| field | type | unit | range or values | 0 means | meaning |\n|---|---|---|---|---|---|"
    for (k = 1; k <= lines; k++) {
        text = row_name[k]; gsub(/,/, "`, `", text); gsub(/  /, " ", row[k])
        print row_name[k] == "" ? row[k] : "| `" text "`" row[k]
    }
}
