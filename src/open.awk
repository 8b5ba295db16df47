# awk -f src/open.awk [-v declare=1] FILE...: rooms of dem.h as objects that are compiled separately. Their functions
# lose `static`, so that other rooms and the tests can call them. With declare=1 only what others need: types, macros,
# tables and inline functions as they are, a prototype in place of each function. A compiler names file
# and line in src/; with declare=1 only if lines=1, because then every edit changes what others include.
FNR == 1 { if (chunk != "") complain("ends inside a declaration"); comment = macro = 0 }
{ line = $0 }
!comment && chunk == "" && (line ~ /^[ \t]*\/\*/ || line == "") { comment = line != "" && line !~ /\*\//; next }
comment { comment = line !~ /\*\//; next }
chunk == "" { start = FNR; depth = 0; macro = line ~ /^#/ }
{ chunk = chunk line "\n" }
macro { if (line !~ /\\$/) { gsub(/\n +static /, "\n    ", chunk); put(chunk); chunk = "" } next }
{
    text = line
    gsub(/\\./, "", text); gsub(/"[^"]*"/, "", text); gsub(/'[^']*'/, "", text); gsub(/\/\*[^*]*\*\//, "", text)
    sub(/\/\*.*/, "", text); sub(/.*\*\//, "", text); sub(/[ \t]+$/, "", text)
    if (text !~ /^#/) depth += gsub(/\{/, "{", text) - gsub(/\}/, "}", text)
    if (depth > 0 || text !~ /([;}]|^DEMI_[A-Z_]+\(.*\))$/) next
    plain = chunk
    sub(/^DEMI_FORMAT\([^)]*\) /, "", plain)
    if (plain ~ /^(static|DEMI_CLONES|DEM_API) [^={;]*\)[ \n]*(\{|;)/ && plain !~ /^static const [a-z_]+ [a-z_]+\[/) {
        if (!sub(/^static /, "", chunk)) sub(/^DEMI_CLONES static /, "DEMI_CLONES ", chunk) || sub(/\) static /, ") ", chunk)
        if (declare && plain !~ /^DEM_API/) {
            sub(/^DEMI_CLONES /, "", chunk)
            sub(/[ \n]*(\{.*|;\n)$/, ";\n", chunk)
            put(chunk)
        } else if (!declare) put(chunk)
    } else if (!declare || plain !~ /_STAGES?[_(]|^DEMI_(MOTION|ANSWER|WHOLE|KEPT|SEIDEL)|^DEMI_[A-Z]+_LAWS\(DEMI_[A-Z]+_STAGES\)/) put(chunk)
    chunk = ""
}
function put(s) { if (!declare || lines) printf "#line %d \"%s\"\n", start, FILENAME; printf "%s", s }
function complain(s) { print FILENAME ": " s > "/dev/stderr"; exit 1 }
