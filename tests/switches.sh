# sh tests/switches.sh [SWITCH...]: the tests with parts of dem.h switched off (manual, 14). Every switch gets rooms of its
# own, opened like those of `make test`. The test programs take turns: each runs with one switch, the next program with
# the next one. A program that names what is switched off does not compile; its turn goes to the next switch. The last
# line is "N passed, N failed"; the exit code is 1 when anything failed. build/switches/turns.txt tells the turns.
switches=${*:-CORE NO_FILES NO_REPLAY NO_REPORTS NO_TRIALS NO_SLABS NO_IMPULSES NO_POLYHEDRA}
CC=${CC:-cc}; dir=build/switches; JOBS=${JOBS:-1}
# groups of 16 bodies are for three tests; one compiles dem.h itself
without="test_api test_feed test_members test_own_law"
flags="-std=c99 -O1 -ffp-contract=off -DDEM_NO_CLONES -I."
mkdir -p $dir build/tmp; rm -f $dir/turns.txt $dir/test_*; touch $dir/turns.txt
for switch in $switches; do
    SWITCH=-DDEM_$switch sh src/open.sh $dir/$switch || exit 1
    # dem.h declares this one always, to refuse it with a reason: here its use does not compile
    case $switch in NO_IMPULSES|CORE) echo '#define DEM_RESPONSE_IMPULSES' ;; esac > $dir/$switch/off.h
    for room in $dir/$switch/*.c; do
        [ "${room%.c}.o" -nt $room ] || echo $CC $flags -w -DDEM_$switch -c $room -o ${room%.c}.o
    done
done | xargs -P $JOBS -I {} sh -c '{} || echo "does not compile: {}"' > $dir/failed.txt
[ ! -s $dir/failed.txt ] || { cat $dir/failed.txt; echo "0 passed, 1 failed"; exit 1; }
[ -f tests/refused.h ] || awk -f tests/refused.awk dem.h > tests/refused.h
count=$(echo $switches | wc -w); number=0; programs=
for test in tests/*/test_*.c; do
    name=$(basename "$test" .c); number=$((number + 1))
    case " $without " in *" $name "*) continue ;; esac
    for step in $(seq 0 $((count - 1))); do
        switch=$(echo $switches | cut -d ' ' -f $(((number + step)%count + 1)))
        rooms=$dir/$switch
        $CC $flags -w -Werror=implicit-function-declaration -DDEM_$switch -include $rooms/private.h -include $rooms/off.h $test $rooms/*.o \
            -o $dir/$name -lm 2> /dev/null || continue
        programs="$programs $dir/$name"; echo "$name with DEM_$switch" >> $dir/turns.txt
        break
    done
done
sh tests/run.sh '' $programs | grep -v '^ok '
