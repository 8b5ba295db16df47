# awk -f tests/tags.awk dem.h: the tags of the contents list at the top of the file (lines that begin
# with >>name, before the first ruled banner) must each head one ruled banner, in the same order; a
# banner that the list does not name is an error too. Tags such as >>add-law inside the text are free.
# A part has at most 900 lines, a function at most 80, a line at most 100 columns. Of the private half: no function is
# declared before it is defined, so no part uses a later one; the functions that rows of a table name are declared by macros.
BEGIN { dashes = "------------------------------------------------------------"; equals = dashes; gsub(/-/, "=", equals) }
{ ruled = index($0, dashes) || index($0, equals) }
length($0) > 100 { complain("line " FNR " has " length($0) " columns, must be at most 100") }
/^(static|DEM_API|DEM_INLINE|DEMI_CLONES) .*\(/ && !/;$/ { function_line = FNR; function_head = $0 }
/^}/ {
    if (function_line && FNR - function_line >= 80)
        complain("line " function_line ": has " FNR - function_line + 1 " lines, must be at most 80: " function_head)
    function_line = 0
}
$1 == ">>platform" && was_ruled { private = 1 }
private && /^(static|DEM_INLINE) [^=]*\(/ { head = ""; in_head = FNR }
in_head {
    head = head $0
    if (/[{=]/) in_head = 0
    else if (/\);$/) { if (head !~ /DEMI_FORMAT/) complain("line " in_head ": is declared before its definition, so that an earlier part can use it: " head); in_head = 0 }
}
$1 ~ /^>>[a-z]/ && !banners_begun && !was_ruled { listed[++lists] = $1; place[$1] = lists }
$1 ~ /^>>[a-z]/ && was_ruled { headed[++heads] = $1; line[heads] = FNR; times[$1]++ }
{ if (ruled) banners_begun = 1; was_ruled = ruled }
END {
    line[heads + 1] = FNR + 1
    for (i = 1; i <= heads; i++)
        if (line[i + 1] - line[i] > 900)
            complain(headed[i] " has " line[i + 1] - line[i] " lines, must be at most 900")
    if (lists == 0) { print FILENAME ": no contents list found"; exit 1 }
    for (i = 1; i <= lists; i++) {
        if (times[listed[i]] == 0) complain(listed[i] " is in the contents, but heads no part")
        if (times[listed[i]] > 1) complain(listed[i] " heads " times[listed[i]] " parts")
        if (place[listed[i]] != i) complain(listed[i] " is twice in the contents")
    }
    for (i = 1; i <= heads; i++) {
        if (!(headed[i] in place)) complain("line " line[i] ": " headed[i] " is not in the contents")
        else if (place[headed[i]] < last) complain("line " line[i] ": " headed[i] " stands after " listed[last])
        else last = place[headed[i]]
    }
    if (!bad) print FILENAME ": " lists " parts, all in order, none too long"
    exit bad
}
function complain(sentence) { print FILENAME ": " sentence; bad = 1 }
