# sh tests/upgrade.sh [long]: tests examples/upgrade.sh. The tables know every public name, field and number of
# arguments that is gone since 0.1.0 or commit 81f58bb (tests/upgrade/names_*.txt). Programs of users, and, with the
# history of git, the examples of both versions and the C of docs/ at 81f58bb, compile after the upgrade with the present dem.h.
# A second run changes nothing. `long` runs programs with the header of 81f58bb and, upgraded, with the present one: they
# print the same.
# The last line is "N passed, N failed".
CC=${CC:-cc} CXX=${CXX:-c++}
dir=build/upgrade; top=$PWD; passed=0; failed=0
rm -rf $dir; mkdir -p $dir
upgrade="sh $top/examples/upgrade.sh"
try() {                                            # NAME COMMAND...
    name=$1; shift
    if ( "$@" ) > $dir/log 2>&1; then passed=$((passed + 1)); echo "ok     $name"
    else failed=$((failed + 1)); echo "FAILED $name"; sed 's/^/       | /' $dir/log | head -20; fi
}
same() { printf '%s\n' "$2" > $dir/expected; printf '%s\n' "$1" | diff $dir/expected -; }
code() { want=$1; shift; "$@"; got=$?; [ $got = "$want" ] || { echo "ends with code $got, not $want: $*"; return 1; }; }
text() { printf '%b' "$2" > "$dir/$1"; }

# --- the tables
$CC -E -dD -I. dem.h 2> $dir/log | awk -f tests/upgrade/names.awk | LC_ALL=C sort -u > $dir/now.txt
try "names of the present dem.h are found" test "$(wc -l < $dir/now.txt)" -gt 500
for version in 0_1_0 81f58bb; do
    try "every public name of $version is there, or has a row" \
        awk -f tests/upgrade/rows.awk examples/upgrade.txt $dir/now.txt tests/upgrade/names_$version.txt
done

# --- programs: they compile after the upgrade, and a second run changes nothing
compiles() {                                       # FILE FLAGS...
    source=$1; shift
    case $source in
    *.cpp) $CXX -std=c++17 -w "$@" -fsyntax-only "$source" ;;
    *) $CC -std=c99 -w -Werror=implicit-function-declaration "$@" -fsyntax-only "$source" ;;
    esac
}
again() {                                          # FILE...: nothing is left to rewrite
    $upgrade --check "$@" > $dir/again.diff 2>/dev/null
    [ ! -s $dir/again.diff ] || { cat $dir/again.diff; return 1; }
}
programs() {                                       # NAME FOLDER FLAGS...: all programs in the folder
    name=$1; in=$2; shift 2
    $upgrade --no-orig "$in"/*.[ch]* > $dir/log 2>&1
    [ $? -lt 2 ] || { cat $dir/log; failed=$((failed + 1)); }
    for source in "$in"/*.c "$in"/*.cpp; do
        [ -f "$source" ] || continue
        try "$name: ${source##*/} compiles after the upgrade" compiles "$source" "$@"
    done
    try "$name: a second run changes nothing" again "$in"/*.[ch]*
}
# a call that each row of `call` fits: the row changes it, and no row fits the result
calls() {
    awk '/^call / {
        while (sub(/ *\\$/, "") && (getline more) > 0) { sub(/^ */, " ", more); $0 = $0 more }
        if (!(at = index($0, "=>"))) next
        s = substr($0, 6, at - 6); list = "int n"
        while (match(s, /\$[0-9](:[a-z_0-9]+)?/)) {
            k = substr(s, RSTART + 1, 1)
            if (RLENGTH > 2) list = list ", " substr(s, RSTART + 3, RLENGTH - 3) " x" k
            s = substr(s, 1, RSTART - 1) "x" k substr(s, RSTART + RLENGTH)
        }
        sub(/\$\*/, "y, z", s)
        print "void f(" list ") { " s "; }"
    }' examples/upgrade.txt > $dir/calls.c
    cp $dir/calls.c $dir/calls_before.c; $upgrade --no-orig $dir/calls.c 2>/dev/null
    diff $dir/calls_before.c $dir/calls.c > $dir/calls.diff
    [ "$(grep -c '^>' $dir/calls.diff)" -eq "$(wc -l < $dir/calls.c)" ] || { cat $dir/calls.c; return 1; }
    again $dir/calls.c
}
try "each row of call rewrites its call, and not the result" calls

mkdir $dir/users $dir/first
cp tests/upgrade/programs/*.* $dir/users; cp tests/upgrade/programs_0_1_0/*.* $dir/first
cp dem.h $dir/dem.h
programs "users" $dir/users -I. -Iexamples/laws
programs "0.1.0" $dir/first

# --- one place of each kind, with tables of the test
mkdir $dir/rows; cp examples/upgrade.sh examples/upgrade.awk $dir/rows
cat > $dir/rows/upgrade.txt <<'END'
name dem_old dem_new
name DEM_OLD DEM_NEW
name dem_old_thing dem_thing
name near dem_near near.h
call dem_cut($1, $2, $3) => dem_slice($1, DEM_KIND, $3)
call dem_swap($1, $2) => dem_turned($2, $1)
call dem_all($1, $*) => dem_every(0, $1, $*)
call dem_fill($1, &$2, $3) => dem_fill($1, $3, $2)
call dem_box_fill($1, $2:dem_box) => dem_box_fill($1, dem_region_make($2))
call dem_zero($1, 0) => dem_one($1)
call dem_zero :: Give 0.
field dem_thing old laws.old
field dem_thing law law.function
field dem_thing removed :: Call dem_removed_set.
gone dem_gone :: Write it yourself.
check dem_changed :: It means something else.
order dem_thing :: Name the fields.
returns dem_box_make dem_box
END
sed 1d tests/upgrade/fields_new.txt > $dir/fields_new.c
upgrade_rows="sh $dir/rows/upgrade.sh"
becomes() {                                        # BEFORE AFTER [NOTE...]: with escapes of printf
    text one.c "$1"; text want.c "$2"
    $upgrade_rows --no-orig $dir/one.c 2> $dir/notes
    cmp $dir/one.c $dir/want.c || { cat $dir/one.c; return 1; }
    [ -z "$3" ] || grep -q "$3" $dir/notes || { cat $dir/notes; return 1; }
    again_rows $dir/one.c
}
again_rows() { cp "$1" $dir/twice.c; $upgrade_rows --no-orig $dir/twice.c 2>/dev/null; cmp $dir/twice.c "$1"; }
try "an identifier is renamed as a whole" becomes 'dem_old dem_older my_dem_old DEM_OLD\n' \
    'dem_new dem_older my_dem_old DEM_NEW\n'
try "a member of that name stays" becomes 'x.dem_old = p->dem_old;\n' 'x.dem_old = p->dem_old;\n'
try "public names in comments are renamed" becomes '/* dem_old\n near */ // dem_old\n' \
    '/* dem_new\n near */ // dem_new\n'
try "public names in strings are renamed as a whole" becomes 'f("dem_old: %d\\ndem_old", "dem_older");\n' \
    'f("dem_new: %d\\ndem_new", "dem_older");\n'
try "names of files stay" becomes 'f("dem_old.stl", "out/dem_old", "dem_old/out");\n#include "dem_old"\n' \
    'f("dem_old.stl", "out/dem_old", "dem_old/out");\n#include "dem_old"\n'
try "a name that belongs to a header stays without it" becomes 'near();\n' 'near();\n'
try "a name that belongs to a header is renamed with it" becomes '#include "examples/near.h"\nnear();\n' \
    '#include "examples/near.h"\ndem_near();\n'
try "arguments are replaced" becomes 'dem_cut(a, b, c);\n' 'dem_slice(a, DEM_KIND, c);\n'
try "a call over several lines keeps its lines" becomes 'dem_cut(a,\n    b, /* b */\n    c);\n' \
    'dem_slice(a, DEM_KIND, /* b */\n    c);\n'
try "calls are nested" becomes 'dem_cut(dem_swap(1, 2), b, dem_swap(f(3, 4), dem_old));\n' \
    'dem_slice(dem_turned(2, 1), DEM_KIND, dem_turned(dem_new, f(3, 4)));\n'
try "commas and brackets in strings, brackets and initialisers" becomes \
    "dem_swap(\"a, (b\", (c){1, ',', x[f(1, 2)]});\\n" \
    "dem_turned((c){1, ',', x[f(1, 2)]}, \"a, (b\");\\n"
try "an apostrophe in a text" becomes "It doesn't call dem_old, \`dem_cut(a, b, c)\` isn't.\\n" \
    "It doesn't call dem_new, \`dem_slice(a, DEM_KIND, c)\` isn't.\\n"
try "all further arguments" becomes 'dem_all(a, b, c); dem_all(a);\n' 'dem_every(0, a, b, c); dem_every(0, a);\n'
try "an address becomes a value" becomes 'dem_fill(w, &r->x[2], 3); dem_fill(w, 3, r);\n' \
    'dem_fill(w, 3, r->x[2]); dem_fill(w, 3, r);\n'
try "an argument of a type" becomes \
    'void f(dem_box b, dem_region r) { dem_box_fill(w, b); dem_box_fill(w, r);'\
' dem_box_fill(w, dem_box_make(1, 2)); }\n' \
    'void f(dem_box b, dem_region r) { dem_box_fill(w, dem_region_make(b)); dem_box_fill(w, r);'\
' dem_box_fill(w, dem_region_make(dem_box_make(1, 2))); }\n'
try "a call that no row fits" becomes 'dem_zero(a, 0);\ndem_zero(a, 1);\n' \
    'dem_one(a);\ndem_zero(a, 1);\n' 'one.c:2: dem_zero: Give 0\.'
try "a function without a call" becomes 'f = dem_cut;\n' 'f = dem_cut;\n' 'one.c:1: dem_cut: '
try "a name that is gone" becomes '\ndem_gone();\n' '\ndem_gone();\n' 'one.c:2: dem_gone: Write it yourself\.'
try "a meaning that changed, in files that are rewritten" becomes 'dem_old; dem_changed;\n' \
    'dem_new; dem_changed;\n' 'dem_changed: It means something else\.'
try "values in order" becomes 'dem_thing t = {1, 2};\n' 'dem_thing t = {1, 2};\n' 'dem_thing: Name the fields\.'
try "no values in order" becomes 'dem_thing t = {0}, u = {.a = 1}; dem_old;\n' \
    'dem_thing t = {0}, u = {.a = 1}; dem_new;\n' '1 places rewritten, 0 left'
try "a type under its old name" becomes 'dem_old_thing *t; t->old = 1;\n' 'dem_thing *t; t->laws.old = 1;\n'
try "a field that became part of a field of its name" becomes 'dem_thing t; t.law = f; t.law.function = f;\n' \
    'dem_thing t; t.law.function = f; t.law.function = f;\n'
try "lines that end with CR LF" becomes 'dem_cut(a,\r\n    b, c);\r\ndem_old\r\n' \
    'dem_slice(a, DEM_KIND, c);\r\ndem_new\r\n'
try "a last line without an end" becomes 'dem_old' 'dem_new'
try "a macro over several lines" becomes '#define F(x) dem_swap(x, \\\n    dem_old)\n' \
    '#define F(x) dem_turned( \\\n    dem_new, x)\n'
fields() {
    cp tests/upgrade/fields.txt $dir/fields.c
    code 1 $upgrade_rows --no-orig $dir/fields.c 2> $dir/notes || { cat $dir/notes; return 1; }
    sed 1d $dir/fields.c | diff $dir/fields_new.c - && again_rows $dir/fields.c &&
        grep -q 'fields.c:23: old: If this is a field of dem_thing, write .laws.old\.' $dir/notes &&
        grep -q 'fields.c:23: removed: Call dem_removed_set\.' $dir/notes &&
        [ "$(grep -c '^[^ ]*:[0-9]*:' $dir/notes)" -eq 2 ]
}
try "fields of variables, pointers, parameters, members, results, casts and initialisers" fields
unchanged() {
    printf '/* r\351sum\351 */ int main(void) { return 0; } "\\"\r\n\tx\n\n  ' > $dir/plain.c
    cp $dir/plain.c $dir/plain_before.c
    code 0 $upgrade --no-orig $dir/plain.c && cmp $dir/plain.c $dir/plain_before.c
}
try "a file without old names keeps every byte" unchanged
keeps() {
    text kept.c 'dem_old\n'; rm -f $dir/kept.c.orig
    code 0 $upgrade_rows $dir/kept.c && same "$(cat $dir/kept.c.orig)" dem_old && same "$(cat $dir/kept.c)" dem_new &&
        code 2 $upgrade_rows $dir/kept.c 2> $dir/notes; grep -q 'kept.c.orig exists' $dir/notes
}
try "the text before is in FILE.orig, which is not replaced" keeps
checks() {
    text check.c 'dem_old\n'
    code 1 $upgrade_rows --check $dir/check.c > $dir/check.diff &&
        same "$(cat $dir/check.c)" dem_old && grep -q '^+dem_new' $dir/check.diff
}
try "--check prints a diff and changes nothing" checks
refuses() {                                        # FILE MESSAGE
    code 2 $upgrade "$1" 2> $dir/notes || return 1
    grep -q -e "$2" $dir/notes && [ "$(wc -l < $dir/notes)" -eq 1 ] || { cat $dir/notes; return 1; }
}
try "a file that does not exist" refuses $dir/nothing.c 'nothing.c does not exist'
try "a folder" refuses $dir 'is a folder'
try "an unknown option" refuses --all '--all is no option'
read_only() {
    text locked.c 'dem_world_time\n'; chmod a-w $dir/locked.c
    refuses $dir/locked.c 'locked.c is read-only' && same "$(cat $dir/locked.c)" dem_world_time
}
try "a read-only file" read_only
odd() {
    text 'a b=c.c' 'dem_old\n'; cp "$dir/a b=c.c" $dir/-x.c
    (cd $dir && code 0 sh rows/upgrade.sh --no-orig 'a b=c.c' -- -x.c) 2>/dev/null && return 1    # options come first
    (cd $dir && code 0 sh rows/upgrade.sh --no-orig -- -x.c 'a b=c.c') &&
        same "$(cat "$dir/a b=c.c" $dir/-x.c)" "dem_new
dem_new"
}
try "names of files with blanks and signs" odd
for other in gawk mawk "busybox awk" original-awk; do
    command -v ${other%% *} >/dev/null ||
        { echo "SKIP: ${other%% *} not found (Debian package ${other%% *})"; continue; }
    with() {
        cp tests/upgrade/fields.txt $dir/fields.c; AWK="$1" $upgrade_rows --no-orig $dir/fields.c
        sed 1d $dir/fields.c | diff $dir/fields_new.c -
    }
    try "the same by $other" with "$other"
done

# --- former versions from the history
old=81f58bb; first=30c2d94
if git cat-file -e $old:dem.h 2>/dev/null && git cat-file -e $first:dem.h 2>/dev/null; then
    for version in $first $old; do
        mkdir -p $dir/$version
        git archive $version examples | (cd $dir/$version && tar -x -f -); cp dem.h $dir/$version
        if [ $version = $first ]; then            # its notes name the header that it needs
            awk '{ print } /^#include "..\/dem.h"/ { print "#include \"../../../../examples/drum.h\"" }' \
                $dir/$version/examples/mill.c > $dir/log
            cp $dir/log $dir/$version/examples/mill.c
        fi
        programs "examples of $version" $dir/$version/examples -I$dir/$version
    done
    mkdir -p $dir/pages/docs $dir/snippets
    for page in README.md CONTRIBUTING.md docs/extending.md docs/laws.md docs/replay.md docs/own_law.md \
            docs/parallel.md docs/impulses.md docs/shapes.md \
            docs/how_to.md docs/how_to_shapes.md docs/how_to_more.md; do
        git show $old:$page > $dir/pages/$page
    done
    (cd $dir/pages && awk -v out=../snippets -f $top/tests/snippets.awk README.md CONTRIBUTING.md docs/*.md) \
        > $dir/log 2>&1
    programs "C of docs/ of $old" $dir/snippets -I. -I$dir/snippets -Iexamples -Iexamples/laws
else echo "SKIP: no history of git here: examples and pages of $first and $old are not upgraded"; fi

# --- results
if [ "$1" = long ] && git cat-file -e $old:dem.h 2>/dev/null; then
    mkdir -p $dir/results/old; git show $old:dem.h > $dir/results/old/dem.h
    git archive $old examples/laws | (cd $dir/results/old && tar -x -f -)
    for header in old new; do
        [ $header = old ] && with=$dir/results/old || with=.
        printf '#define DEM_IMPLEMENTATION\n#include "dem.h"\n' > $dir/results/dem_$header.c
        try "dem.h, $header, compiles" \
            $CC -std=c99 -O1 -ffp-contract=off -I$with -c $dir/results/dem_$header.c -o $dir/results/dem_$header.o
    done
    results() {                                    # PROGRAM ARGUMENTS...
        program=$1; shift
        $CC -std=c99 -O1 -w -ffp-contract=off -I$dir/results/old -I$dir/results/old/examples/laws \
            -Itests/upgrade/programs tests/upgrade/programs/$program.c \
            $dir/results/dem_old.o -o $dir/results/$program.old -lm &&
        $CC -std=c99 -O1 -w -ffp-contract=off -I. -I$dir/users -Iexamples/laws \
            $dir/users/$program.c $dir/results/dem_new.o -o $dir/results/$program.new -lm || return 1
        for which in old new; do
            mkdir -p $dir/results/$which.run
            (cd $dir/results/$which.run && ../$program.$which "$@" > $program.txt 2>/dev/null) ||
                { echo "$program.$which ends with an error"; return 1; }
        done
    }
    # Trajectories have moved in their last bits since then. Impacts agree in all digits but those of the ledger's residual;
    # the mean friction of sheared grains agrees within four of its errors, both printed as "mean +- error".
    collide() {
        results collide || return 1
        for which in old new; do sed 's/, residual.*//' $dir/results/$which.run/collide.txt > $dir/results/$which.txt; done
        diff $dir/results/old.txt $dir/results/new.txt
    }
    shear() {
        results shear5 40 || return 1
        awk 'NR == FNR { was[FNR] = $0; rows++; next }
            { n = split(was[FNR], a, " ")
              if (split($0, b, " ") != n) bad = 1
              for (i = 2; i < n; i++) if (b[i] == "+-") {
                  d = a[i - 1] - b[i - 1]; e = (a[i + 1] + 0)^2 + (b[i + 1] + 0)^2; all++
                  if (!(d*d <= 16*e)) { print was[FNR] " | " $0; bad = 1 }
              } }
            END { exit bad || FNR != rows || all < 6 }' $dir/results/old.run/shear5.txt $dir/results/new.run/shear5.txt
    }
    try "collide.c prints the same impacts as with the header of $old" collide
    try "shear5.c prints the same mean friction as with the header of $old" shear
elif [ "$1" = long ]; then echo "SKIP: no history of git here: results are not compared with those of $old"; fi
echo "$passed passed, $failed failed"
[ $failed = 0 ]
