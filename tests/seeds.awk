# awk -f tests/seeds.awk docs/seeds*.md: checks the rows that judge the claims of published texts. A row is a line of a table
# whose header is "place | ... | dem.h | verdict | command".
#   - its verdict is one of four; if it is "not done", or only "partly" done without other conditions, the row names what is missing
#   - it has a command unless it is "not done" or about a layout; the program is one that the project has, with its options;
#     make has the target; the words of FILTER are in the name of a test (tests/studies.sh runs the commands of the studies)
#   - the table of counts in docs/seeds.md is that of the rows
# Prints the counts; exit code 1 if something is wrong. -v counts=1: prints the table of counts for the page.
BEGIN {
    verdicts = split("reproduced|partly|contradicted|not done", verdict, "|")
    text_of["docs/seeds_mill.md"] = "tumbling mill"
    text_of["docs/seeds_screener.md"] = "screening machine"
    text_of["docs/seeds_gas.md"] = "gas of ellipsoids"
    texts = split("tumbling mill|screening machine|gas of ellipsoids|separator on GPUs|separator", text, "|")
    tests_read()
}
FNR == 1 { inside = 0; kind = text_of[FILENAME] }
/^## Multidisperse/ { kind = text[4] }
/^## Granular flows/ { kind = text[5] }
/^\| place \|/ { inside = 1; next }
/^\|-/ { next }
!/^\|/ { inside = 0 }
FILENAME == "docs/seeds.md" && /^\| (tumbling mill|screening machine|gas of ellipsoids|separator|separator on GPUs|all) \| [0-9]/ {
    n = split($0, cell, / *\| */)
    for (i = 0; i <= verdicts; i++) shown[cell[2], i] = cell[3 + i]
    next
}
inside {
    line = $0
    gsub(/\\\|/, "/", line)
    n = split(line, cell, / *\| */)
    if (n != 7) { wrong("has " n - 2 " cells instead of 5"); next }
    which = 0
    for (i = 1; i <= verdicts; i++) if (cell[5] == verdict[i]) which = i
    if (!which) { wrong("has the verdict \"" cell[5] "\""); next }
    if (which == 4 && cell[4] !~ /missing: /) wrong("is not done and does not say what is missing")
    if (which < 4 && cell[6] == "" && cell[4] !~ /layout/) wrong("is judged and has no command")
    if (cell[6] != "") command(cell[6])
    count[kind, 0]++; count[kind, which]++; count["all", 0]++; count["all", which]++
}
END {
    text[++texts] = "all"
    if (counts) print "| text | rows | reproduced | partly | contradicted | not done |\n|---|---|---|---|---|---|"
    for (t = 1; t <= texts; t++) {
        line = "| " text[t]
        for (i = 0; i <= verdicts; i++) {
            line = line " | " count[text[t], i] + 0
            if (!counts && count[text[t], i] + 0 != shown[text[t], i]) {
                print "docs/seeds.md: " text[t] ": the table has " shown[text[t], i] " rows " (i ? verdict[i] : "in all") ", the pages have " count[text[t], i] + 0
                bad = 1
            }
        }
        if (counts) print line " |"
    }
    if (!counts && !bad) print count["all", 0] " claims, each with its verdict and command"
    exit bad
}
function wrong(what) { print FILENAME ":" FNR ": the row " what; bad = 1 }
function command(text,   word, n, i, program, source) {
    if (text !~ /^`[^`]*`$/) { wrong("has a command that is not between backquotes"); return }
    gsub(/`/, "", text)
    if (match(text, /FILTER="[^"]*"/)) {
        program = substr(text, RSTART + 8, RLENGTH - 9)
        if (index(names, program) == 0) wrong("names no test: " program)
        return
    }
    n = split(text, word, " ")
    if (word[1] == "make") {
        if (!("make " word[2] in known)) known["make " word[2]] = system("grep -q '^" word[2] ":' Makefile") == 0
        if (!known["make " word[2]]) wrong("names no target of make: " word[2])
        return
    }
    program = word[1]; sub(/^build\//, "", program)
    if (!(program in source_of)) source_of[program] = read("examples/" program ".c") read("bench/" program ".c") read("examples/study.h")
    for (i = 2; i <= n; i++)
        if (word[i] ~ /^--/ && index(source_of[program], "{\"" substr(word[i], 3) "\"") == 0 && index(source_of[program], "\"" word[i] "\"") == 0)
            wrong("gives " program " the unknown option " word[i])
}
function read(file,   line, all) {
    while ((getline line < file) > 0) all = all line "\n"
    close(file)
    return all
}
# the names of all tests; a name may go on in the next line
function tests_read(   line, list, open) {
    list = "cat tests/*/*.c"
    while ((list | getline line) > 0) {
        if (match(line, /TEST\("/)) { open = 1; line = substr(line, RSTART + 5); names = names "\n" }
        if (!open) continue
        if (line ~ /\{ *$/) open = 0
        sub(/\) *\{ *$/, "", line); sub(/^ *"/, "", line); sub(/" *$/, "", line)
        names = names line
    }
    close(list)
}
