#!/bin/sh
# sh examples/upgrade.sh [--check] [--no-orig] FILE...: rewrites programs in C or C++ that were written for dem.h 0.1.0,
# or for a version since, to the names and calls of the present dem.h.
#
#   --check      changes no file: prints a diff
#   --no-orig    keeps no copy; otherwise FILE.orig keeps the text before, and must not exist yet
#
# Give all files of a program together, so that the types of members and variables that one file declares are known in
# the others. For every place that the script cannot rewrite it prints FILE:LINE: NAME: and what to do, to standard
# error. A second run changes nothing.
# Exit codes: 0, all is done (--check: nothing would change); 1, something is left to you (--check: or would change);
# 2, a file cannot be read or written, or an option is unknown.
#
# The tables are in upgrade.txt beside this script, one row a line. `#` begins a comment line, `\` at the end of a line
# continues the row. REMEDY is a sentence.
#
#   name OLD NEW [HEADER]            an identifier; with HEADER only in files that include HEADER. Names that begin with
#                                    dem_ or DEM_ are renamed in comments and strings too
#   call OLD($1, $2) => NEW($2, 0)   a call, by the first row of OLD whose arguments fit. NEW is any text. $1 fits any
#                                    argument, $* all that follow, &$1 an argument that begins with & ($1 is the rest),
#                                    $1:TYPE an argument of this type or a pointer to it, other text only itself
#   call OLD :: REMEDY               calls of OLD that no row fits
#   field STRUCT OLD NEW             a field of variables, pointers, members and results of this type, and `.OLD =` in
#                                    their initialisers. NEW may be a path, such as laws.normal
#   field STRUCT OLD :: REMEDY       a field that is gone
#   gone NAME :: REMEDY              a name that is gone
#   order STRUCT :: REMEDY           initialisers of this type that list values in order
#   check NAME :: REMEDY             a name whose meaning changed: printed once per file in which another row rewrote
#   member FIELD TYPE                the type of a field of dem.h, for rows of `field` and $1:TYPE
#   returns FUNCTION TYPE            the type that a function of dem.h returns
#
# Rows of `name`, `call` and `field` may end with `:: REMEDY` too: the script rewrites the place and prints REMEDY.
# A new name must not be an old one, and a row of `call` must not fit its own result. tests/upgrade.sh checks both.
LC_ALL=C; export LC_ALL
here=$(dirname -- "$0")
check=; keep=1
while :; do
    case $1 in
    --check) check=1; shift ;;
    --no-orig) keep=; shift ;;
    --) shift; break ;;
    --help) sed -n '2,/^LC_ALL/s/^# \{0,1\}//p' "$0"; exit 0 ;;
    -*) echo "upgrade.sh: $1 is no option; give --check, --no-orig or names of files" >&2; exit 2 ;;
    *) break ;;
    esac
done
[ $# -gt 0 ] || { echo "upgrade.sh: no file is given; use: sh $0 [--check] [--no-orig] FILE..." >&2; exit 2; }
writable() { [ -w "$1" ] && [ -n "$(find -L "$1" -prune -perm -u+w)" ]; }
first=1
for file in "$@"; do                              # a name that begins with - is no option
    [ $first = 1 ] && set --; first=0
    case $file in -*) file=./$file ;; esac
    set -- "$@" "$file"
done
bad=0
refuse() { echo "upgrade.sh: $1" >&2; bad=2; }
for file in "$@"; do
    if [ -d "$file" ]; then refuse "$file is a folder; give names of files"
    elif [ ! -e "$file" ]; then refuse "$file does not exist; correct its name"
    elif [ ! -r "$file" ]; then refuse "$file cannot be read; allow it with chmod u+r"
    elif [ -z "$check" ] && ! writable "$file"; then
        refuse "$file is read-only; allow writing with chmod u+w, or use --check"
    elif [ "$check" ] || [ -z "$keep" ] || [ ! -e "$file.orig" ]; then :
    else refuse "$file.orig exists; move it away, or use --no-orig"; fi
done
[ $bad = 0 ] || exit $bad
TABLE=$here/upgrade.txt; TO=$(mktemp -d "${TMPDIR:-/tmp}/upgrade.XXXXXX") || exit 2; OPEN=; number=0
trap 'rm -rf "$TO"' 0
trap 'exit 2' 1 2 15
for file in "$@"; do number=$((number + 1)); [ -z "$(tail -c 1 "$file")" ] || OPEN="$OPEN $number"; done
export TABLE TO OPEN
${AWK:-awk} -f "$here/upgrade.awk" "$@" >&2 || exit 2
number=0; code=0
for file in "$@"; do
    number=$((number + 1)); name=$file
    [ -f "$TO/$number.count" ] || { refuse "$name: awk gave no result"; exit 2; }
    read -r changes left < "$TO/$number.count"
    cat "$TO/$number.notes" >&2
    [ "$left" = 0 ] || code=1
    cmp -s "$file" "$TO/$number.new" && continue
    if [ "$check" ]; then
        code=1
        printf '%s\n' "--- $name" "+++ $name"
        diff -u "$file" "$TO/$number.new" | sed 1,2d
    else
        { [ -z "$keep" ] || cp -p "$file" "$file.orig"; } && cat "$TO/$number.new" > "$file" ||
            { refuse "$name: cannot be written"; exit 2; }
        echo "$name: $changes places rewritten, $left left to you${keep:+ (before: $name.orig)}" >&2
    fi
done
exit $code
