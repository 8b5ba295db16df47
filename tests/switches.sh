# sh tests/switches.sh [SWITCH...]: the tests with parts of dem.h switched off. Every switch (manual, 14) gets a library of
# its own. The test programs take turns: each runs with one switch, the next program with the next one. A program that
# names a private function, or a public one that is switched off, cannot be compiled and is left out; its turn goes to
# the next switch. The last line is "N passed, N failed"; the exit code is 1 when anything failed.
switches=${*:-CORE NO_FILES NO_REPLAY NO_REPORTS NO_TRIALS NO_SLABS NO_IMPULSES NO_POLYHEDRA}
CC=${CC:-cc}; dir=build/switches
flags="-std=c99 -O1 -ffp-contract=off -DDEM_NO_CLONES -I."
mkdir -p $dir build/tmp; : > $dir/turns.txt
failed=0; count=0; programs=
for switch in $switches; do
    count=$((count + 1))
    [ $dir/$switch.o -nt dem.h ] || $CC $flags -Wall -Wextra -Werror -DDEM_$switch -c dem.c -o $dir/$switch.o || failed=1
done
[ $failed = 0 ] || { echo "0 passed, 1 failed"; exit 1; }
number=0
for test in tests/*/test_*.c; do
    $CC $flags -w -Werror=implicit-function-declaration -fsyntax-only $test 2> /dev/null || continue   # private names
    number=$((number + 1)); name=$(basename "$test" .c)
    for step in $(seq 0 $((count - 1))); do
        switch=$(echo $switches | cut -d ' ' -f $(((number + step)%count + 1)))
        $CC $flags -w -Werror=implicit-function-declaration -DDEM_$switch $test $dir/$switch.o -o $dir/$name -lm 2> /dev/null ||
            continue
        programs="$programs $dir/$name"; echo "$name with DEM_$switch" >> $dir/turns.txt
        break
    done
done
JOBS=${JOBS:-1} sh tests/run.sh '' $programs | grep -v '^ok '
