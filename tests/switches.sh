# sh tests/switches.sh [SWITCH...]: the tests with parts of dem.h switched off. Every switch (manual, 14) gets a library of
# its own. The test programs take turns: each runs with one switch, the next program with the next one. A program that
# names a private function is left out; the turn of one that calls a function that is switched off goes to the next
# switch. The last line is "N passed, N failed"; the exit code is 1 when anything failed.
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
for switch in $switches; do nm $dir/$switch.o | awk '$2 == "T" { print $3 }' | sort > $dir/$switch.names; done
number=0
for test in tests/*/test_*.c; do
    name=$(basename "$test" .c)
    $CC $flags -w -Werror=implicit-function-declaration -c $test -o $dir/$name.o 2> /dev/null || continue   # private names
    number=$((number + 1))
    nm -u $dir/$name.o | awk '/ dem_/ { print $2 }' | sort > $dir/$name.needs
    for step in $(seq 0 $((count - 1))); do
        switch=$(echo $switches | cut -d ' ' -f $(((number + step)%count + 1)))
        [ "$(comm -23 $dir/$name.needs $dir/$switch.names)" ] && continue
        programs="$programs $dir/$name"; echo "$name with DEM_$switch" >> $dir/turns.txt
        $CC $flags -w -Werror=implicit-function-declaration -DDEM_$switch $test $dir/$switch.o -o $dir/$name -lm || rm -f $dir/$name
        break
    done
done
JOBS=${JOBS:-1} sh tests/run.sh '' $programs | grep -v '^ok '
