# awk -f tests/pages.awk build/code.now README.md docs/*.md docs/data/*.csv: compares the stamps of figures with the code that
# they depend on (build/code.now: what bench/code.sh prints). A line per block or table, in the order of bench/figures.txt.
# Fails if a stamp is missing or malformed, a block and its row of bench/figures.txt do not agree, a part of the code is
# missing, or a page calls figures preliminary; with -v strict=1 also if figures are older than their code.
BEGIN { FS = "|" }
NR == FNR {
    rows++
    page_of[rows] = $1; block_of[rows] = $2; command_of[rows] = $3; parts_of[rows] = $4; digests_of[rows] = $5
    row[$1, $2] = rows
    n = split($4, part, ","); split($5, digest, ",")
    for (i = 1; i <= n; i++) if (digest[i] == 0 && !(part[i] in lacking)) {
        lacking[part[i]] = 1
        fault("bench/figures.txt: " part[i] (part[i] ~ /^>>/ ? " heads no part of dem.h" : " is no file"))
    }
    next
}
FNR == 1 { ended(); page = FILENAME; if (page ~ /\.csv$/) table($0) }
tolower($0) ~ /preliminary/ { fault(page ":" FNR ": figures are called preliminary; measure again, or leave them out") }
page ~ /\.csv$/ { next }
begun { begun = 0; stamp(block, $0) }
/^<!-- [^ :]+: begin -->$/ {
    ended()
    block = $0; sub(/^<!-- /, "", block); sub(/: begin -->$/, "", block); begun = 1; inside = 1
    if (seen[page, block]++) fault(page ": there are two blocks " block)
    if (!((page, block) in row)) fault(page ": block " block " has no row in bench/figures.txt")
}
/^<!-- [^ :]+: end -->$/ {
    if (!inside || $0 != "<!-- " block ": end -->") fault(page ":" FNR ": " $0 " ends no block")
    inside = 0
}
END {
    ended()
    for (r = 1; r <= rows; r++) {
        name = page_of[r] (block_of[r] == "-" ? "" : " " block_of[r])
        if (!seen[page_of[r], block_of[r]]) { fault(page_of[r] ": " (block_of[r] == "-" ? "the table" : "block " block_of[r]) " of bench/figures.txt is not there"); continue }
        if (!(r in code)) continue
        changed = compare(r)
        if (changed == "") { current++; print "current              " name; continue }
        older++
        print "OLDER THAN ITS CODE  " name ": " changed "; measure again: " command_of[r]
    }
    print "pages: " current + 0 " current, " older + 0 " older than their code, " faults + 0 " faults"
    exit faults > 0 || (strict && older > 0)
}
function fault(text) { print "FAULT  " text; faults++ }
function ended() { if (inside) fault(page ": block " block " has no end"); inside = 0; begun = 0 }
# the stamp of a block: the line below its begin
function stamp(block, line) {
    if (line !~ /^<!-- [^ :]+: .*; commit .*; code .* -->$/ || index(line, "<!-- " block ": ") != 1) {
        fault(page ": block " block " has no stamp below its begin; bench/pages.sh writes it"); return
    }
    sub(/^<!-- [^ :]+: /, "", line); sub(/ -->$/, "", line)
    keep(block, line)
}
function table(line) {
    seen[page, "-"] = 1
    if (!((page, "-") in row)) { fault(page ": has no row in bench/figures.txt"); return }
    if (line !~ /^# .*; commit .*; code /) { fault(page ": has no stamp in its first line; bench/pages.sh writes it"); return }
    sub(/^# /, "", line)
    keep("-", line)
}
# COMMAND; PROCESSOR...; commit HASH; code PARTS DIGESTS
function keep(block, line,   field, n, word, part, digest) {
    n = split(line, field, "; ")
    if (n < 4 || field[1] ~ /^ *$/ || field[2] ~ /^ *$/ ||
        field[n - 1] !~ /^commit (unknown|[0-9a-f]+)$/ || (field[n - 1] != "commit unknown" && length(field[n - 1]) < 14) ||
        split(field[n], word, " ") != 3 || word[1] != "code" || word[3] !~ /^[0-9]+(,[0-9]+)*$/ ||
        (word[3] != "0" && split(word[2], part, ",") != split(word[3], digest, ","))) {
        fault(page ": the stamp of " (block == "-" ? "the table" : "block " block) " is not COMMAND; PROCESSOR; commit HASH; code PARTS DIGESTS")
        return
    }
    if ((page, block) in row) { commit[row[page, block]] = field[n - 1]; code[row[page, block]] = word[2] " " word[3] }
}
# what has changed since the figures were measured; empty if nothing has
function compare(r,   word, part, digest, n, i, was, list, count) {
    split(code[r], word, " ")
    n = split(word[2], digest, ","); split(word[1], part, ",")
    if (word[2] != "0") for (i = 1; i <= n; i++) was[part[i]] = digest[i]
    n = split(parts_of[r], part, ","); split(digests_of[r], digest, ",")
    for (i = 1; i <= n; i++) if (!(part[i] in was) || was[part[i]] != digest[i]) { count++; list = list (list == "" ? "" : ", ") part[i] }
    if (!count) return ""
    if (commit[r] == "commit unknown") return "the commit of its code is unknown"
    return (count == n ? (n == 1 ? "its code, " list ", has" : "all " n " parts of its code have") : (count == 1 ? list " has" : list " have")) " changed since " commit[r]
}
