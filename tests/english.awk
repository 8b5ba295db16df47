# awk -f tests/english.awk FILE...: sentences that need a second reading, one line each: file:line: rule: sentence.
#   *.md         prose, headings, lists and table cells; blocks and spans of code are left out
#   dem.h        comments of the public half, and error messages and test-like strings of the other
#   *.c, *.h     error messages and the names of tests (TEST("..."))
# A sentence that has to stay is listed in tests/english.txt: FILE|part of the sentence|reason.
# -v count=1: only how many there are per rule and file.
BEGIN {
    n = 0
    rule("tells, told", "(tells?|told)")
    rule("stands", "(stands?|stood)")
    rule("hangs on", "hangs? on")
    rule("meets, meeting (say: collide, contact)", "(meets?|met|meetings?)")
    rule("one's own, of your own (say: user-defined)", "(one's own|of your own|of one's own)")
    rule("by hand", "by hand")
    rule("come along", "comes? along")
    rule("by itself (say: automatically, individually)", "by (itself|themselves|himself)")
    rule("anew (say: rebuilt, again)", "anew")
    rule("nobody, somebody, whoever", "(nobody|somebody|whoever|whatever it takes)")
    rule("near list (say: pruned neighbour list)", "near lists?")
    rule("kept contact (say: persistent contact)", "kept contacts?")
    rule("law's memory (say: contact history)", "law's memory")
    rule("price (say: cost)", "(prices?|dearer|dearest)")
    rule("mended (say: fixed)", "mended")
    rule("passive without an actor", "(is|are|was|were) (told|asked|refused)")
    rule("looks as a noun (say: iterations)", "(looks at each|[0-9]+ looks)")
    rule("film (say: replay)", "films?")
    rule("told apart (say: statistically significant)", "told apart")
    rule("push, pull as nouns", "(a|the|its|their|this) (push|pull)")
    rule("turned round", "turn(s|ed) round")
    rule("is had (say: is available)", "(is|are) had")
    rule("preliminary", "preliminary")
    rule("sentence (say: error message)", "(a|the|its|one) sentence")
    while ((getline text < "tests/english.txt") > 0)
        if (split(text, part, "|") >= 3) { kept++; keep_file[kept] = part[1]; keep_text[kept] = part[2] }
}
function rule(name, words) { n++; names[n] = name; words_of[n] = "(^|[^A-Za-z_'])" words "($|[^A-Za-z_'])" }
FNR == 1 {
    finish()
    page = FILENAME ~ /\.md$/; header = FILENAME ~ /(^|\/)dem\.h$/
    code = 0; comment = 0; private = 0; api = 0; text = ""
}
page && /^<!-- .* -->$/ { finish(); next }
page && /^ *```/ { finish(); code = !code; next }
page && code { next }
page {
    line = $0
    gsub(/``[^`]*``|`[^`]*`/, "CODE", line)
    gsub(/\]\([^)]*\)/, "]", line)
    gsub(/<[^>]*>/, "", line)
    gsub(/https?:[^ )]*/, "LINK", line)
    if (line ~ /^ *\|/) {
        finish()
        cells = split(line, cell, "|")
        for (i = 1; i <= cells; i++) { add(cell[i]); finish() }
        next
    }
    if (line ~ /^ *$/ || line ~ /^#/ || line ~ /^ *([-*]|[0-9]+\.) / || line ~ /^ *[-|: ]+$/) finish()
    sub(/^#+ */, "", line); sub(/^ *([-*]|[0-9]+\.) /, "", line)
    add(line)
    if ($0 ~ /^#/) finish()
    next
}
header && /^ *>>api$/ { api = 1 }
header && />>implementation - / { finish(); private = 1 }
header && !private {
    line = $0
    if (!comment) {
        if (!match(line, /\/\*/)) next
        line = substr(line, RSTART + 2); comment = 1
    }
    ended = match(line, /\*\//)
    if (ended) line = substr(line, 1, RSTART - 1)
    # indented by four or more after the comment's margin: code, a table, references
    if (line ~ /^       / && $0 !~ /[;,] +\/\*/ && in_manual(line)) finish(); else if (line ~ /^ *-*$/) finish(); else add(line)
    if (ended) { finish(); comment = 0 }
    next
}
function in_manual(line) { return line ~ /^       [^ ]/ && !api }
# error messages: the strings that begin with the name of a call; names of tests
/TEST\(|demi_(fail|refuse)\(|"dem_[a-z_]+: |"%s: / { catching = 1 }
catching {
    line = $0
    while (match(line, /"([^"\\]|\\.)*"/)) {
        add(substr(line, RSTART + 1, RLENGTH - 2)); line = substr(line, RSTART + RLENGTH)
        if (line !~ /^ *$/ && line !~ /^ *"/) { finish(); if (line ~ /^[,)]/) { catching = catching && line !~ /\) *\{|;/ } }
    }
    if (/;|\) *\{/) { finish(); catching = 0 }
}
function add(line) {
    if (text == "") first = FNR
    gsub(/^ +| +$/, "", line)
    if (line == "") return
    at[++pieces] = length(text); line_of[pieces] = FNR; file = FILENAME
    text = text (text == "" ? "" : " ") line
}
function finish(   rest, offset, sentence, end) {
    rest = text; offset = 0
    while (rest != "") {
        end = match(rest, /[.!?][")]* +["(A-Z\[]/) ? RSTART : length(rest)
        sentence = substr(rest, 1, end)
        judge(sentence, where(offset))
        rest = substr(rest, end + 1); offset += end
        if (match(rest, /^[")]* +/)) { rest = substr(rest, RLENGTH + 1); offset += RLENGTH }
    }
    text = ""; pieces = 0
}
function where(offset,   i, l) {
    l = first
    for (i = 1; i <= pieces && at[i] <= offset; i++) l = line_of[i]
    return l
}
function judge(s, line,   i) {
    for (i = 1; i <= n; i++) if (tolower(s) ~ words_of[i]) found(names[i], s, line)
    if (s ~ /^(What|Who|Of|By) / && s !~ /\?$/) found("begins with What, Who, Of or By", s, line)
    if (s ~ /(^|[^0-9A-Za-z_.)\]%])\.[0-9]/) found("a figure without its leading zero", s, line)
    if (s ~ /[0-9]+( [a-zA-Z%\/]+)?; [-+0-9.e]+( [a-zA-Z%\/0-9]+)?(;|,|$)/) found("figures between semicolons", s, line)
    if (page && s ~ /\+-/) found("+- in place of ±", s, line)
}
function found(name, s, line,   i) {
    for (i = 1; i <= kept; i++) if (file == keep_file[i] && index(s, keep_text[i])) return
    bad++
    if (count) tally[file ": " name]++
    else print file ":" line ": " name ": " substr(s, 1, 160)
}
END {
    finish()
    for (key in tally) print tally[key] " " key
    if (!bad) print "english: nothing that needs a second reading"
    exit bad > 0
}
