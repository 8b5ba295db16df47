# awk -f tests/calls.awk dem.h: every call of a user-defined function is an argument of DEMI_USER, DEMI_USER_FREE or
# DEMI_USER_WITHIN, so that functions that change the world fail while it runs.
# Names of user-defined functions are those of the public pointers to functions (fields and types), and in the private
# half all variables of such a type. A call is one of these names, after . or -> unless it is a variable, and "(".
# Built-in laws have the same type: calls by rows of their tables, laws->..., are not the user's.
function strip(s) { gsub(/"([^"\\]|\\.)*"/, "\"\"", s); return s }
{
    s = strip($0)                                           # without texts and comments
    if (comment) { if (!sub(/^.*\*\//, "", s)) s = ""; else comment = 0 }
    while (match(s, /\/\*/)) {
        head = substr(s, 1, RSTART - 1); rest = substr(s, RSTART + 2)
        if ((end = index(rest, "*/")) > 0) s = head " " substr(rest, end + 2)
        else { s = head; comment = 1 }
    }
    if ($1 == ">>platform" && was_ruled) private = 1
    was_ruled = /-----/
    text[FNR] = s; half[FNR] = private
}
!private && match(s, /\(\*[a-z_]+\)\(/) {                   # typedef RESULT (*dem_..._fn)( or RESULT (*field)(
    name = substr(s, RSTART + 2, RLENGTH - 4)
    if (s ~ /^typedef/) type[name]; else field[name]
}
# the call at column `from` of line n is good if an open parenthesis before it, up to 12 lines above, is that of a macro
function call(name, n, from,    before, k, depth, c, one) {
    calls++
    for (k = 0; k < 12 && k < n; k++) {
        before = k ? text[n - k] : substr(text[n], 1, from - 1)
        for (c = length(before); c > 0 && (one = substr(before, c, 1)) !~ /[{}]/; c--) {
            depth += (one == ")") - (one == "(")
            if (depth >= 0) continue
            if (substr(before, 1, c - 1) ~ /DEMI_USER(_FREE|_WITHIN)?$/) return
            depth = 0
        }
        if (c > 0) break                                    # the begin of a block
    }
    print FILENAME ":" n ": calls the user's function " name " outside DEMI_USER: " text[n]
    bad = 1
}
END {
    for (n = 1; n <= FNR; n++) {                            # fields and variables of those types
        s = text[n]
        while (match(s, /dem_[a-z_]+_fn [a-z_]+[;,)=\[ ]/)) {
            split(substr(s, RSTART, RLENGTH - 1), word, " ")
            if (word[1] in type) { field[word[2]]; if (half[n]) local[word[2]] }
            s = substr(s, RSTART + RLENGTH)
        }
        if (half[n] && match(s = text[n], /^static dem_[a-z_]+_fn demi_[a-z_]+\(/)) {
            split(substr(s, RSTART, RLENGTH - 1), word, " ")
            if (word[2] in type) returns[word[3]]           # FUNCTION(...)( calls what FUNCTION returns
        }
    }
    for (n = 1; n <= FNR; n++) {
        if (!half[n]) continue
        s = text[n]
        while (match(s, /\(\*[a-z_.>\-]*[a-z_]+\)\(/)) {        # (*w->desc.law)(
            name = head = substr(s, RSTART + 2, RLENGTH - 4)
            sub(/.*(\.|->)/, "", name)
            if (substr(s, 1, RSTART - 1) !~ /(void|int|double|dem_[a-z_]+) \**$/ && ((head != name && name in field) || name in local))
                call(name, n, RSTART)
            sub(/\(\*/, "( ", s)
        }
        s = text[n]
        at = 0
        while (match(substr(s, at + 1), /[a-z_0-9]+\(/)) {
            from = at + RSTART; at += RSTART + RLENGTH - 1
            name = substr(s, from, RLENGTH - 1)
            head = substr(s, 1, from - 1)
            if (head ~ /laws->[a-z]+->$/) continue
            if (name in returns && substr(s, at) ~ /^\([^()]*\)\(/) call(name, n, from)
            else if (head ~ /(\.|->)$/ ? name in field : head !~ /[a-z_0-9] $/ && name in local) call(name, n, from)
        }
    }
    for (name in field) fields++
    if (fields < 15 || calls < 20) { print FILENAME ": found only " fields " names and " calls " calls of user-defined functions"; bad = 1 }
    if (!bad) print FILENAME ": " calls " calls of user-defined functions, all marked"
    exit bad
}
