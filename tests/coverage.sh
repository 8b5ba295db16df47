# sh tests/coverage.sh: which lines and branches of src/ the tests execute, and which functions none of them calls. It
# builds the tests and relations with gcc --coverage -O0 in build/coverage, apart from the usual objects, and runs them.
# PROGRAMS="test_maths test_rows": only these programs; PROGRAMS=relations: only relations, of N (400) scenes; OF=core:
# only the tests of tests/core; FILTER=words as in make test; JOBS (1) at a time. Output: a table, also in
# build/out/coverage/page.md, and pages by genhtml if it is installed.
# Counted are lines with code. These rules keep what needs a failed allocation apart:
#   - a line counts as covered if any of it is executed, so `if (!DEMI_GROW(...)) return 0;` is covered by the call;
#   - branches of a line with DEMI_GROW( or demi_alloc( are not counted.
# All functions that one use of a macro defines have one line, that of the use. A branch there counts as taken if it is
# taken in one of them. An inline function that no room and no test of this run calls is not compiled and is absent.
# The last lines are totals and "N passed, N failed" of the tests; the exit code is 1 when a test failed.
for tool in gcc gcov; do
    command -v $tool >/dev/null 2>&1 || { echo "SKIP: $tool not found (Debian package gcc)"; exit 0; }
done
JOBS=${JOBS:-1}; top=$PWD; dir=build/coverage; out=build/out/coverage
[ "$PROGRAMS" ] || PROGRAMS="$(ls tests/${OF:-[a-z]*}/test_*.c)$([ "$OF" ] || echo " relations")" || exit 1
programs=$(for program in $PROGRAMS; do [ $program = relations ] || echo "build/$(basename "$program" .c)"; done)
relations=; case " $(echo $PROGRAMS) " in *" relations "*) relations=build/relations;; esac
mkdir -p $dir/build/tmp $out
# A copy of the sources keeps their times, so that make compiles what has changed. A test that compiles dem.h into
# itself gets src/dem.h, which includes the rooms.
(cd $dir && rm -rf src tests examples Makefile dem.h dem.c)
cp -rp src tests examples Makefile dem.c $dir && cp -p src/dem.h $dir/dem.h || exit 1
cd $dir || exit 1
find build -name '*.gcda' -exec rm -f {} +
MAKEFLAGS= OPEN_LINES=1 make -s -o dem.h -o tests/refused.h CC=gcc CPPFLAGS="-Isrc -DDEM_NO_CLONES" \
    CFLAGS="-std=c99 -O0 -ffp-contract=off --coverage" LDFLAGS=--coverage JOBS="$JOBS" $programs $relations || exit 1
awk -f src/join.awk src/dem.h > dem.h          # tests read it
failed=0; echo "0 passed, 0 failed" > build/tests.log
[ -z "$programs" ] || JOBS=$JOBS sh tests/run.sh "$FILTER" $programs > build/tests.log || failed=1
grep FAILED build/tests.log
[ -z "$relations" ] || OMP_WAIT_POLICY=passive build/relations --scenes ${N:-400} || failed=1
: > build/all.gcov                             # one line of src/ is in many objects
for object in build/rooms/*.gcda build/obj/*.gcda; do
    gcov -b -c -t "$object" >> build/all.gcov 2>> build/gcov.log
done
sed -n 's/^#include "\([a-z]*\/.*\)"/src\/\1/p' src/dem.h > build/rooms.txt
LC_ALL=C awk -v info=build/all.info '
    FILENAME ~ /rooms.txt$/ { rooms[++room_count] = $0; known[$0] = 1; next }
    /^ +-: +0:Source:/ { file = $0; sub(/^[^S]*Source:/, "", file); keep = file in known; next }
    !keep { next }
    /^-----/ { getline; next }   # the functions of a macro, one after another
    /^function / { name = $2; sub(/\..*/, "", name); calls = $4; named = 1; next }
    /^branch / { if (!spared) branch(file SUBSEP line, $2 + 0, $3 == "taken" ? $4 : 0); next }
    /^ *[^ :]+: *[0-9]+:/ {
        split($0, part, ":"); count = part[1]; gsub(/[ *]/, "", count); line = part[2] + 0
        spared = /DEMI_GROW\(|demi_alloc\(/
        if (named) function_at(file, line, name, calls)
        named = 0
        if (count == "-" || line == 0) next
        if (line > last[file]) last[file] = line
        ran[file, line] += count + 0           # ##### is 0
        next
    }
    function branch(at, k, taken) { if (k >= branches[at]) branches[at] = k + 1; took[at, k] += taken }
    function function_at(file, line, name, calls,   i) {
        for (i = 1; i <= begun[file, line]; i++) if (names[file, line, i] == name) break
        if (i > begun[file, line]) { begun[file, line] = i; names[file, line, i] = name }
        called[file, line, i] += calls
    }
    function percent(a, b) { return b ? sprintf("%.1f %%", 100*a/b) : "-" }
    function row(name, l, c, b, t) {
        printf "| %s | %d | %d | %s | %d | %d | %s |\n", name, c, l, percent(c, l), t, b, percent(t, b)
    }
    function flush_lines(   s) {               # ", 12-15" for a run of lines that are not covered
        if (from) missed = missed (missed == "" ? "" : ", ") (from == to ? from : from "-" to)
        from = 0
    }
    function flush_function() {
        flush_lines()
        if (missed != "" && now != "") text = text sprintf("- `%s`, %s: %s\n", now, room, missed)
        missed = ""
    }
    function folder_row() {
        if (folder != "") row("**" folder "**", fl, fc, fb, ft)
        fl = fc = fb = ft = 0
    }
    END {
        print "| room | lines covered | lines | | branches taken | branches | |\n|---|---|---|---|---|---|---|"
        for (r = 1; r <= room_count; r++) {
            room = rooms[r]; split(room, part, "/")
            if (part[2] != folder) { folder_row(); folder = part[2] }
            l = c = b = t = 0; now = ""
            print "TN:\nSF:" room > info
            for (i = 1; i <= last[room]; i++) {
                if (begun[room, i]) {
                    flush_function(); now = ""
                    for (k = 1; k <= begun[room, i]; k++) {
                        functions++
                        print "FN:" i "," names[room, i, k] > info
                        print "FNDA:" called[room, i, k] + 0 "," names[room, i, k] > info
                        if (called[room, i, k]) { reached++; now = names[room, i, k] }
                        else dead_text = dead_text sprintf("- `%s`, %s:%d\n", names[room, i, k], room, i)
                    }
                }
                if (!((room, i) in ran)) continue
                l++; print "DA:" i "," ran[room, i] > info
                if (ran[room, i]) { c++; flush_lines() } else { if (!from) from = i; to = i }
                for (k = 0; k < branches[room, i]; k++) if ((room, i, k) in took) {   # other numbers are calls
                    b++; t += took[room, i, k] > 0
                    print "BRDA:" i ",0," k "," took[room, i, k] + 0 > info
                }
            }
            flush_function()
            print "end_of_record" > info
            if (l) row(room, l, c, b, t)
            fl += l; fc += c; fb += b; ft += t; al += l; ac += c; ab += b; at += t
        }
        folder_row(); row("**all**", al, ac, ab, at)
        printf "\n## Functions that no test reaches: %d of %d\n\n%s", functions - reached, functions, dead_text
        printf "\n## Lines that no test reaches, of the other functions\n\n%s", text
        printf "\nlines %s (%d of %d), branches %s (%d of %d), functions %s (%d of %d)\n", percent(ac, al), ac, al,
            percent(at, ab), at, ab, percent(reached, functions), reached, functions
    }' build/rooms.txt build/all.gcov > build/table.md || exit 1
{
    echo "# Coverage of src/ by the tests and relations"; echo
    echo "Tests: $(echo $programs $relations | sed 's/build\///g')${FILTER:+, filter \"$FILTER\"}."; echo
    cat build/table.md
    tail -n 1 build/tests.log
} > "$top/$out/page.md"
sed 1,4d "$top/$out/page.md"
if command -v genhtml >/dev/null 2>&1; then genhtml -q --branch-coverage -o "$top/$out" build/all.info
else echo "SKIP: genhtml not found (Debian package lcov): no HTML pages"; fi
exit $failed
