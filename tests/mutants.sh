# sh tests/mutants.sh: do the tests notice a wrong dem.h? It draws N (200) small errors by SEED (1) from all rooms of
# src/ (OF=core: only from src/core; see tests/mutants.awk), compiles the rooms with each of them, and runs the tests
# until one fails: first those of the room's folder, then the others, short ones first, and last 400 scenes of relations.
# PROGRAMS="test_maths test_rows": only these tests. JOBS (1) mutants at a time. Output: "killed by TEST: FILE:LINE:
# BEFORE -> AFTER" or "SURVIVED ...".
#   - A mutant that does not compile, or whose objects are those of dem.h at -O1, is drawn again.
#   - A test fails, too, if it takes longer than 10 times its time and 10 s, or 8 GB of memory.
#   - An inline function is changed in all rooms, but not in the tests.
#   - test_own_law compiles dem.h into itself and is left out; so is src/api/law-rows.h, which only such programs use.
# build/mutants/log.txt keeps the results. A run with the same SEED and src/ continues where the last one ended, and
# tries survivors again if the tests have changed. It works on a copy, so the sources may be edited meanwhile.
dir=build/mutants; base=$dir/base; tab=$(printf '\t')
build() {                                      # FOLDER OPTION... TARGET...: never joins dem.h
    (cd "$1" && shift && MAKEFLAGS='' make -s -o dem.h -o tests/refused.h CC="$CC" CFLAGS="$CFLAGS" OMP="$OMP" \
        CPPFLAGS="-DDEM_NO_CLONES $CPPFLAGS" JOBS="${threads:-1}" "$@" > build/make.log 2>&1)
}
try() {                                        # FOLDER TEST SECONDS: true if it passes; it may not fill the machine
    (cd "$1" && ulimit -c 0 && ulimit -v 8000000 && ulimit -f 4000000 && OMP_WAIT_POLICY=passive \
        timeout -k 5 "$3" "build/$2" $4 > build/run.log 2>&1 < /dev/null; exit $?) 2>/dev/null
    code=$?
    [ $code -eq 0 ] && grep -q "^$2: [0-9].* 0 \(failed\|broken\)\$" "$1/build/run.log"
}
mutant() {                                     # the first candidate that compiles to something else; sets result
    result=none
    while IFS="$tab" read -r slot file at text new <&3; do
        room=$file; line=$at; what=$text       # `read` empties its names at the end
        rm -rf "$work/src" "$work/build/rooms"
        cp -rp $base/src "$work"; cp -rp $base/build/rooms "$work/build"
        NEW=$new awk -v at="$line" 'FNR == at { print ENVIRON["NEW"]; next } { print }' "$base/$room" > "$work/$room"
        build "$work" -o build/rooms/private.h $(cd $base && ls build/rooms/*.o) || continue
        for object in $base/build/rooms/*.o; do
            cmp -s "$object" "$work/build/rooms/$(basename "$object")" || { result=SURVIVED; break; }
        done
        [ $result = none ] || break
    done 3< "$work/candidates"
    [ $result = none ] && return
    folder=${room#src/}; folder=${folder%%/*}
    for order in $(awk -v f="$folder" '{ print ($1 != f), $2, $3 }' $dir/order.txt |
            sort -n -k 1,1 -k 2,2 | tr ' ' ,); do
        test=${order##*,}; seconds=${order#*,}; seconds=${seconds%,*}
        build "$work" -o build/rooms/private.h "build/$test" ||
            { echo "$test does not link: $room:$line" >&2; continue; }
        try "$work" "$test" $((10*seconds + 10)) || { result="killed by $test"; break; }
        rm -f "$work/build/$test"
    done
    if [ "$result" = SURVIVED ] && [ -s $base/build/relations.time ]; then
        rm "$work/dem.h"; cp "$work/src/dem.h" "$work/dem.h"; rm "$work/build/obj"; mkdir "$work/build/obj"
        if CPPFLAGS=-Isrc build "$work" build/relations; then
            try "$work" relations $((10*$(cat $base/build/relations.time) + 10)) "--scenes 400" ||
                result="killed by relations"
        else echo "relations do not compile: $room:$line" >&2; fi
    fi
    [ "$result" != SURVIVED ] && [ $code -eq 124 ] && result="$result (time limit)"
}
if [ "$1" = -one ]; then                       # SLOT
    [ "$2" ] || exit 0                         # xargs without a slot
    work=$dir/work.$2
    rm -rf "$work"; mkdir -p "$work/build/tmp"
    for file in Makefile tests examples docs dem.h dem.c; do ln -s "../base/$file" "$work/$file"; done
    ln -s ../../base/build/obj "$work/build/obj"; cp -p $base/build/flags "$work/build"
    grep "^$2$tab" $dir/draws.txt > "$work/candidates"
    mutant
    colon=": "; [ "$result" = SURVIVED ] && colon=" "
    text="$result$colon$room:$line: $what"; [ "$result" = none ] && text="none: no candidate of $room is left"
    printf '%s\t%s\t%s\t%s\t%s\n' "$SEED" "$SOURCE" "$2" "$TESTS" "$text" >> $dir/log.txt
    printf '%s\n' "$text"
    rm -rf "$work"; exit 0
fi
command -v timeout >/dev/null 2>&1 || { echo "SKIP: timeout not found (Debian package coreutils)"; exit 0; }
export SEED="${SEED:-1}" CC="${CC:-cc}" CFLAGS="${CFLAGS:--std=c99 -ffp-contract=off} -O1" OMP SOURCE TESTS
N=${N:-200}; threads=${JOBS:-1}
tests=$(for t in ${PROGRAMS:-tests/*/test_*.c tests/hard/hard_*.c}; do basename "$t" .c; done | grep -vx test_own_law)
mkdir -p $base/build/tmp; rm -rf $dir/work.* $base/src $base/tests $base/examples $base/docs
cp -rp src tests examples docs Makefile dem.c $base || exit 1
awk -f src/join.awk src/dem.h > $base/dem.h    # tests read it
SOURCE=$({ echo "$OF $CC $CFLAGS"; cat src/dem.h src/*/*.h tests/mutants.awk; } | cksum | tr ' ' -)
TESTS=$({ echo "$tests"; cat tests/*.h tests/*/*.[ch]; } | cksum | tr ' ' -)
build $base $(for t in $tests; do echo "build/$t"; done) || { cat $base/build/make.log; exit 1; }
: > $dir/order.txt
for t in $tests; do                            # FOLDER SECONDS TEST, without errors; measured again if the test is new
    if ! [ "$base/build/$t.time" -nt "$base/build/$t" ]; then
        began=$(date +%s)
        try $base "$t" 7200 || { echo "FAILED without an error: $t, which is left out"; continue; }
        echo $(($(date +%s) - began)) > "$base/build/$t.time"
    fi
    folder=$(dirname tests/*/"$t".c)
    echo "${folder#tests/} $(cat "$base/build/$t.time") $t" >> $dir/order.txt
done
if [ -z "$PROGRAMS" ] && build $base build/relations; then
    began=$(date +%s); rm -f $base/build/relations.time
    if try $base relations 7200 "--scenes 400"; then echo $(($(date +%s) - began + 1)) > $base/build/relations.time
    else echo "FAILED without an error: relations, which are left out"; fi
fi
[ -s $dir/order.txt ] || { echo "mutants: no test passes"; exit 1; }
LC_ALL=C awk -v seed="$SEED" -v most="$N" -f tests/mutants.awk \
    $(sed -n 's/^#include "\([a-z]*\/.*\)"/src\/\1/p' src/dem.h | grep -v /law-rows |
    grep "^src/${OF:+$OF/}") > $dir/draws.txt || exit 1
touch $dir/log.txt
# slots whose result holds: of the same sources, and killed, or with the same tests
old() {
    awk -F '\t' -v seed="$SEED" -v source="$SOURCE" -v tests="$TESTS" -v n="$N" '$1 == seed && $2 == source && $3 <= n {
        text[$3] = $5 ~ /^SURVIVED/ && $4 != tests ? "" : $5 } END { for (s = 1; s <= n; s++) if (text[s] != "")
        print s "\t" text[s] }' $dir/log.txt
}
old > $dir/old.txt; cut -f 2- $dir/old.txt
cut -f 1 $dir/draws.txt | uniq | awk 'FILENAME != "-" { had[$1] = 1; next } !($1 in had)' $dir/old.txt - |
    xargs -P "$threads" -n 1 sh $base/tests/mutants.sh -one
old | awk -F '\t' '$2 ~ /^killed/ { k++ } $2 ~ /^SURV/ { s++ }
    END { printf "mutants: %d, %d killed, %d survived (%.1f %% killed)\n", k + s, k, s, k + s ? 100*k/(k + s) : 0 }'
