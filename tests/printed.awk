# awk -f tests/printed.awk PROGRAM.expected LOG: has a program of docs/how_to*.md printed what its page shows? Blanks do
# not count. A line "..." stands for any lines. Numbers may differ by 5 % of their size; where the first line of the file
# is "varies" (figures of time and of threads), by anything, and lines may be others, too, but for the words of the first.
function words(line) { gsub(/[-+]?[0-9]+[.]?[0-9]*(e[-+]?[0-9]+)?/, "#", line); gsub(/[ \t]+/, " ", line); sub(/^ /, "", line); sub(/ $/, "", line); return line }
function figures(line, list,    k) {
    k = 0
    while (match(line, /[-+]?[0-9]+[.]?[0-9]*(e[-+]?[0-9]+)?/)) { list[++k] = substr(line, RSTART, RLENGTH); line = substr(line, RSTART + RLENGTH) }
    return k
}
function alike(a, b,    one, other, k, n, gap) {
    if (words(a) != words(b)) return 0
    n = figures(a, one); figures(b, other)
    for (k = 1; k <= n; k++) {
        gap = one[k] - other[k]; if (gap < 0) gap = -gap
        if (gap > 0.05*(one[k] < 0 ? -one[k] : one[k]) && one[k] != other[k]) return 0
    }
    return 1
}
FNR == NR { if (FNR == 1) varies = $1 == "varies"; else if ($0 != "") shown[++count] = $0; next }
{ sub(/\r$/, ""); if ($0 != "") got[++lines] = $0 }
END {
    if (varies) { if (words(shown[1]) == words(got[1])) exit 0; print "shows: " shown[1] "\nprints: " got[1]; exit 1 }
    g = 1
    for (s = 1; s <= count; s++) {
        if (shown[s] == "...") { any = 1; continue }
        while (any && g <= lines && !alike(shown[s], got[g])) g++
        if (g > lines || !alike(shown[s], got[g])) { print "shows: " shown[s] "\nprints: " got[g]; exit 1 }
        g++; any = 0
    }
    if (!any && g <= lines) { print "prints also: " got[g]; exit 1 }
}
