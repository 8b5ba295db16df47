# awk -f tests/links.awk page.md...: every relative link and picture must lead to a file, and every
# reference key in square brackets, such as [HER82], must stand in dem.h's list of references.
BEGIN {
    while ((getline text < "dem.h") > 0)
        if (text ~ /^ +\[[A-Z]+[0-9]*\] /) { split(text, part, /[][]/); known[part[2]] = 1 }
}
/^```/ { code = !code }
code { next }
{
    rest = $0
    gsub(/`[^`]*`/, "", rest)
    keys = rest
    while (match(rest, /\]\([^)]*\)/)) {
        target = substr(rest, RSTART + 2, RLENGTH - 3)
        rest = substr(rest, RSTART + RLENGTH)
        sub(/#.*/, "", target)
        if (target == "" || target ~ /^[a-z]+:/) continue
        folder = FILENAME
        if (!sub(/\/[^\/]*$/, "/", folder)) folder = ""
        links++
        if (system("test -e '" folder target "'") != 0) complain("no file " target)
    }
    while (match(keys, /\[[A-Z]+[0-9]*\]/)) {
        key = substr(keys, RSTART + 1, RLENGTH - 2)
        after = substr(keys, RSTART + RLENGTH, 1)
        keys = substr(keys, RSTART + RLENGTH)
        if (after != "(" && !(key in known)) complain("[" key "] is not among dem.h's references")
    }
}
END { if (!bad) print links + 0 " links lead somewhere"; exit bad }
function complain(sentence) { print FILENAME ":" FNR ": " sentence; bad = 1 }
