# awk -f bench/lessons.awk LOG...: what the lessons measured, as a table for docs/teaching.md. A log is the output of one
# lesson, in a folder of its name (build/out/02_pile/log). It takes these lines and skips all others:
#   QUANTITY  MEASURED [+- ERROR] [!]  EXPECTED [within PER_CENT %]     as lesson_row of examples/lesson.h prints it
#   QUANTITY  MEASURED [+- ERROR] [!]  LOW to HIGH                      as lesson_range prints it
#   name = MEASURED [+- ERROR] [UNIT]                                   name without blanks
# EXPECTED alone counts only below the headings "measured" and "expected".
# A quantity that begins with blanks continues the one above it, up to its colon. Two kinds are left out: checks of the
# lesson itself, and times, which need a quiet machine. Fails if a log has no line of a result.
BEGIN {
    number = "[-+]?[0-9]+[.]?[0-9]*(e[-+]?[0-9]+)?"
    within = " " number " within " number " %$"
    range = " " number " to " number "$"
    alone = "(  +|!)" number "$"
    own = "^(letters |bits of |mesh and plane |open edges |floor and wall |effects that miss )"
    timed = "^(price |cost |time of |step with )"
    print "| lesson | quantity | measured | expected |"
    print "|---|---|---|---|"
}
FNR == 1 {
    check()
    lesson = FILENAME; sub(/\/[^\/]*$/, "", lesson); sub(/.*\//, "", lesson)
    title = lesson; sub(/^0/, "", title); gsub(/_/, " ", title)
    rows = 0; above = ""; below = 0
}
{ sub(/[ \r]+$/, ""); expected = "" }
/ measured +expected$/ { below = 1; next }
match($0, within) || match($0, range) || (below && match($0, alone)) {
    expected = substr($0, RSTART, RLENGTH); sub(/^[ !]+/, "", expected)
    rest = substr($0, 1, RSTART - 1)
    sub(/ +!? *$/, "", rest)
    error = ""
    if (match(rest, " *([+]-|±) *" number "$")) {
        error = substr(rest, RSTART); sub(/^[^0-9.]*/, "", error)
        rest = substr(rest, 1, RSTART - 1)
    }
    if (!match(rest, " " number "$")) next
    value = substr(rest, RSTART + 1)
    name = substr(rest, 1, RSTART - 1); sub(/ +$/, "", name)
    if (name ~ /^ /) { sub(/^ +/, above, name) } else { above = name; if (!sub(/:.*/, ": ", above)) above = "" }
    row(name, value, error, expected)
    next
}
match($0, "^[a-z][A-Za-z0-9_.]* = " number) {
    name = $1; value = $3; error = ""; unit = $4
    if ($4 == "+-" || $4 == "±") { error = $5; unit = $6 }
    row(name (unit != "" ? " [" unit "]" : ""), value, error, "")
}
END { check(); exit bad }

function row(name, value, error, expected,   digits) {
    rows++
    if (name ~ own || name ~ timed) return
    while (match(name, /(^| )[.][0-9]/)) name = substr(name, 1, RSTART + RLENGTH - 3) "0" substr(name, RSTART + RLENGTH - 2)
    if (error + 0 > 0) {                # as many digits as the error has, of which two count
        digits = 1 - floor(log(error)/log(10))
        if (digits < 0) digits = 0
        if (digits < 6) { value = sprintf("%.*f", digits, value); error = sprintf("%.*f", digits, error) }
        value = value " ± " error
    }
    if (expected ~ / to /) { split(expected, limit, " to "); if (limit[1] == limit[2]) expected = limit[1] }
    sub(/ within 0 %$/, "", expected)
    gsub(/[|]/, "/", name)
    gsub(/\[/, "(", name); gsub(/\]/, ")", name)       # [N] would be a reference
    printf "| %s | %s | %s | %s |\n", title, name, value, expected
    title = ""
}
function floor(x) { return int(x) <= x ? int(x) : int(x) - 1 }
function check() {
    if (lesson != "" && !rows) { print "bench/lessons.awk: " lesson " prints no result that can be read" | "cat 1>&2"; bad = 1 }
}
