# awk -v seed=SEED -v most=N -f tests/mutants.awk ROOM...: draws small errors in bodies of functions for mutants.sh,
# but not in comments, strings and macros. Output: up to 8 candidates for each of N slots, one a line with tabs between
# SLOT FILE LINE "BEFORE -> AFTER" NEW_LINE. Slots take rooms in turn, in an order drawn anew for each turn; then a kind
# and a line are drawn. The same seed gives the same first slots for every N.
#   compare   < to <= or >, == to !=       logic     && to ||
#   plus      + to -, += to -=             return    return 0 to return 1
#   times     * to /                       delete    a statement on one line
#   constant  3 to 4, 0.5 to 1             negate    if (...) to if (!(...))
# The random numbers are those of Park and Miller, because every awk has others.
function random(n) { x = x*16807 % 2147483647; return int(n*(x/2147483647)) }
function mask(s,   out, c, i) {            # comments, strings and characters become blanks
    for (i = 1; i <= length(s); i++) {
        c = substr(s, i, 1)
        if (inside == "" && (c == "\"" || c == "\047")) { inside = c; c = "_" }
        else if (inside == "" && substr(s, i, 2) == "/*") { inside = "*"; i++; c = "  " }
        else if (inside == "*" && substr(s, i, 2) == "*/") { inside = ""; i++; c = "  " }
        else if (inside != "") {
            if (inside != "*" && c == "\\") { i++; c = "__" }
            else { if (c == inside && c != "*") inside = ""; c = inside == "*" ? " " : "_" }
        }
        out = out c
    }
    return out
}
function trim(s) { gsub(/^ +| +$/, "", s); return s }
function put(kind, at, size, text,   k, line, shown) {   # replaces `size` characters by text
    if (at < first) return
    k = FILENAME SUBSEP kind
    line = substr($0, 1, at - 1) text substr($0, at + size)
    shown = trim($0) " -> " (kind == "delete" ? "(deleted)" : trim(line))
    sites[k, ++count[k]] = FILENAME "\t" FNR "\t" shown "\t" line
}
# each match of `re`: the operator is its text without the characters around it
function swap(kind, re, from, to,   s, off, at, size, op, k, a, b) {
    split(from, a, ","); split(to, b, ",")
    for (s = m " "; match(s, re); s = substr(s, RSTART + RLENGTH - 1)) {
        at = off + RSTART + 1; size = RLENGTH - 2; op = substr(s, RSTART + 1, size); off += RSTART + RLENGTH - 2
        if (substr(m, 1, at - 1) ~ /[0-9.][eE]$/) continue
        for (k in a) if (a[k] == op) put(kind, at, size, b[k])
    }
}
function numbers(   s, off, at, t, v) {
    s = trim(m)
    if (s ~ /^[a-z_0-9 ]+ +\**[a-z_]+[^(=]*;$/ && s !~ /^return/) return       # the length of an array
    for (s = m; match(s, /[A-Za-z_.0-9]+([eE]-?[0-9]+)?/); s = substr(s, RSTART + RLENGTH)) {
        at = off + RSTART; t = substr(s, RSTART, RLENGTH); off += RSTART + RLENGTH - 1
        if (t ~ /^[0-9]+$/) { v = t + 1; put("constant", at, length(t), sprintf("%d", v)) }
        else if (t ~ /^[0-9]*\.?[0-9]*([eE]-?[0-9]+)?$/ && t ~ /^[0-9.]*[0-9]/)
            put("constant", at, length(t), sprintf("%.15g", 2*t))
    }
}
function negate(   s, off, at, depth, i, c) {
    for (s = m; match(s, /(if|while) \(/); s = substr(s, RSTART + RLENGTH)) {
        at = off + RSTART + RLENGTH; off += RSTART + RLENGTH - 1; depth = 1
        for (i = at; i <= length(m) && depth; i++) { c = substr(m, i, 1); depth += (c == "(") - (c == ")") }
        if (!depth) put("negate", at, i - 1 - at, "!(" substr($0, at, i - 1 - at) ")")
    }
}
function find(   s) {
    swap("compare", " (<|>|<=|>=|==|!=) ", "<,<=,>,>=,==,!=", random(2) ? "<=,<,>=,>,!=,==" : ">,<,<,>,!=,==")
    swap("plus", " [-+] |[])A-Za-z0-9_][-+][A-Za-z0-9_(]", "+,-", "-,+")
    swap("plus", " [-+]= ", "+=,-=", "-=,+=")
    swap("times", "[])A-Za-z0-9_][*/][A-Za-z0-9_(]", "*,/", "/,*")
    swap("logic", " (&&|[|][|]) ", "&&,||", "||,&&")
    if (match(m, /return [01];/)) put("return", RSTART + 7, 1, 1 - substr(m, RSTART + 7, 1))
    numbers(); negate()
    s = trim(m)
    # not a declaration, nor the end of a statement that begins above
    if (s ~ /^[A-Za-z_*(].*;$/ && s !~ /[{}]|^(return|case|else|goto|default)/ && before ~ /[;{})]$|else$/ &&
        s !~ /^[a-z_0-9]+ +\**[a-z_]+[^(]*[;=,\[]/ && gsub(/\(/, "(", s) == gsub(/\)/, ")", s))
        put("delete", match(m, /[^ ]/), length(s), ";")
}
FNR == 1 { rooms[++room_count] = FILENAME; inside = ""; body = head = macro = 0; if (!x) x = seed*7919 + 12345 }
{ m = mask($0); sub(/ +$/, "", m); first = 1 }
macro || m ~ /^#/ { macro = m ~ /\\$/; next }
m == "" { next }
!body {
    if (m ~ /^[A-Za-z]/) head = m ~ /\(/ && m !~ /=/
    if (head && m ~ /\) \{$/) body = 1
    else if (head && match(m, /\) \{ .*\}$/)) { first = RSTART + 3; before = ";"; find() }
    else if (m ~ /;$/) head = 0
    before = ";"; next
}
m == "}" { body = head = 0; next }
{ find(); before = m }
END {
    kinds = split("compare plus times constant logic return delete negate", kind, " ")
    for (i = 0; i < 20; i++) random(2)
    for (slot = 1; slot <= most && !empty; ) {
        for (i = room_count; i > 1; i--) { k = random(i) + 1; t = rooms[i]; rooms[i] = rooms[k]; rooms[k] = t }
        empty = 1
        for (i = 1; i <= room_count && slot <= most; i++) {
            for (tries = k = 0; k < 8; k++) {
                have = 0
                for (n = 1; n <= kinds; n++)
                    if (count[rooms[i], kind[n]]) some[have++] = rooms[i] SUBSEP kind[n]
                if (!have) break
                t = some[random(have)]; n = random(count[t]) + 1
                print slot "\t" sites[t, n]; sites[t, n] = sites[t, count[t]--]; tries++
            }
            if (tries) { slot++; empty = 0 }
        }
    }
}
