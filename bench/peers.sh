# sh bench/peers.sh: the scenes of bench/scenes.h in dem.h, LAMMPS and LIGGGHTS, and the blocks of bench/blocks.c in
# dem.h, LIGGGHTS (clumps) and YADE (clumps, cubes), in turns, from the same start states. Prints medians and the
# ratios dem.h : other code. A code that is missing is skipped, loudly.
# What is compared is each code's own time of its loop of steps, after 100 untimed ones; every turn is a
# process of its own. One core: all on processor PROCESSOR. Two: two threads of dem.h, bound to cores, against
# two ranks of the others, bound to cores. Inputs are bench/peers/CODE_SCENE.in or .py, each with the skin, newton
# setting and style that made that code fastest. Start states are bench/data/*.txt (made anew, in minutes, by
# build/bench --settle bed, drum or gas, build/blocks --settle clumps or cubes); the others read them from
# build/peers, written here by build/bench --codes build/peers and build/blocks --codes build/peers. A code compiled
# for the machine is up to a quarter faster than a distribution's package: name yours with LAMMPS=, LIGGGHTS=, YADE=.
# Of blocks what is compared is the time of the processor, on one core: others may run beside. YADE takes half a
# second for a step of cubes: it does one step in 25, and is given 25 times its time. clumps.unshared is dem.h with
# DEM_CLUSTER_CONTACTS_SEPARATE, the law of the others: each two spheres that touch are a contact by themselves.
#   STEPS=N    steps of bed, drum and blocks; gas takes five times as many        ROUNDS=N    turns
#   CORES="1 2"   SCENES="bed drum gas clumps cubes"   PROCESSOR=0   LAMMPS=lmp   LIGGGHTS=liggghts   YADE=yade
#   WARM=500   DT=5e-6    of blocks: steps before the timed ones; time step, s
ROUNDS=${ROUNDS:-5}
STEPS=${STEPS:-500}
CORES=${CORES:-1 2}
SCENES=${SCENES:-bed drum gas clumps cubes}
WARM=${WARM:-500}
DT=${DT:-5e-6}
LAMMPS=${LAMMPS:-lmp}
LIGGGHTS=${LIGGGHTS:-liggghts}
YADE=${YADE:-yade}
dir=build/peers
mkdir -p $dir
rm -f $dir/*.times $dir/*.out

found() { command -v "$1" >/dev/null 2>&1; }
codes=; suffix_omp=
if found $LAMMPS; then
    codes=lammps
    echo "# $($LAMMPS -h </dev/null 2>/dev/null | awk '/Simulator/ { sub(/.*Simulator - */, "LAMMPS "); print; exit }')"
    # its threaded styles are the faster ones in bed, also on one thread
    $LAMMPS -h </dev/null 2>/dev/null | grep -qw OPENMP && suffix_omp="-sf omp -pk omp 1"
else echo "SKIP: $LAMMPS not found (Debian package lammps): no vs_lammps"; fi
if found $LIGGGHTS; then
    codes="$codes liggghts"
    echo "# $($LIGGGHTS -help </dev/null 2>/dev/null | awk '/LIGGGHTS/ { print; exit }')"
else echo "SKIP: $LIGGGHTS not found (Debian package liggghts): no vs_liggghts"; fi
if found $YADE; then
    codes="$codes yade"
    echo "# YADE $($YADE --version 2>&1 </dev/null | awk '/[Vv]ersion/ { print $NF; exit }')"
else echo "SKIP: $YADE not found (Debian package yade): no vs_yade"; fi
[ "$codes" ] || exit 0
pin=; if found taskset; then pin="taskset -c ${PROCESSOR:-0}"; else echo "SKIP: taskset not found, processes may wander"; fi
two=
case " $CORES " in *" 2 "*)
    two=2
    if [ "$(getconf _NPROCESSORS_ONLN 2>/dev/null || echo 1)" -lt 2 ]; then echo "SKIP: one processor, no threads2"; two=
    elif ! found mpirun; then echo "SKIP: mpirun not found (Debian package openmpi-bin), no threads2"; two=; fi
esac
case " $CORES " in *" 1 "*) one=1 ;; *) one= ;; esac
asked() { case " $SCENES " in *" $1 "*) true ;; *) false ;; esac; }
if asked bed || asked drum || asked gas; then
    for c in single O2; do [ -x build/bench_$c ] || echo "SKIP: build/bench_$c is missing (make bench-peers builds it)"; done
    [ -x build/bench ] || { echo "build/bench is missing: run make bench-peers"; exit 1; }
    build/bench --codes $dir || exit 1
fi
if asked clumps || asked cubes; then
    [ -x build/blocks ] || { echo "build/blocks is missing: run make bench-peers"; exit 1; }
    build/blocks --codes $dir || exit 1
fi
case $codes in *liggghts*) asked clumps && {
    $LIGGGHTS -in bench/peers/liggghts_clumps_put.in -log none -var data $dir/clumps >$dir/put.out 2>&1 </dev/null ||
        { echo "clumps: liggghts broke; its output is $dir/put.out"; exit 1; }; }
esac
blocks() { [ $1 = clumps ] || [ $1 = cubes ]; }
steps_of() { if [ $1 = gas ]; then echo $((5*STEPS)); else echo $STEPS; fi; }

# one turn: SCENE CODE CORES; appends "seconds contacts kinetic bytes" to a file of times; of blocks the last
# but one is joined by the way that the middle of the bed sank
turn() {
    scene=$1; code=$2; cores=$3; steps=$(steps_of $1); grid="1 1 1"
    if [ $cores = 2 ]; then grid="2 1 1"; [ $scene = drum ] && grid="1 2 1"; fi
    set -- $grid
    screen=$dir/$scene.$code.$cores.out
    out=$dir/$scene.$code.$cores.times
    start=$pin; [ $cores = 2 ] && start="env OMP_PROC_BIND=true OMP_PLACES=cores"
    case $code.$scene in
    yade.*)
        part=1; [ $scene = cubes ] && part=25
        OMP_NUM_THREADS=1 $start $YADE -j 1 -n -x bench/peers/yade_$scene.py $dir/$scene.txt $(((steps + part - 1)/part)) \
            $((WARM/part)) $DT >$screen 2>&1 </dev/null
        awk -v all=$steps -v done=$(((steps + part - 1)/part)) \
            '$1 == "raw" { print $2*all/done, $3, $4, $6, $5; n++ } END { exit !n }' $screen >>$out ;;
    liggghts.clumps)
        OMP_NUM_THREADS=1 $start $LIGGGHTS -in bench/peers/liggghts_clumps.in -log none -var data $dir/clumps -var steps $steps \
            -var warm $WARM -var dt $DT >$screen 2>&1 </dev/null
        # two runs, of two lines of numbers each; the first of them has the height at the start
        awk '/^processor [0-9]+ *$/ { if (spent) time = ($2 - spent)*1e-9; spent = $2 }
            NF == 4 && $1 ~ /^[0-9]+$/ { k = $2; c = $3; high[++n] = $4 }
            /[Mm]emory .*Mbytes/ { sub(/.*= */, ""); bytes = $1*1048576 }
            END { if (time == "" || n != 4) exit 1
                printf "%s %.5f %.6g %.0f %.6g\n", time, c*8/2, k, bytes/1000, high[1] - high[4] }' $screen >>$out ;;
    lammps.*|liggghts.*)
        program=$LIGGGHTS; options=
        [ $code = lammps ] && program=$LAMMPS && [ $scene = bed ] && options=$suffix_omp
        [ $cores = 2 ] && start="mpirun --allow-run-as-root --oversubscribe --bind-to core -np 2"
        OMP_NUM_THREADS=1 $start $program $options -in bench/peers/${code}_$scene.in -log none -var data $dir/$scene.data \
            -var stl $dir/drum.stl -var steps $steps -var px $1 -var py $2 -var pz $3 >$screen 2>&1 </dev/null
        # the last loop: its time, and the line of numbers before it
        awk '/^Loop time/ { time = $4; kinetic = k; touches = c } NF == 3 && $1 ~ /^[0-9]+$/ { k = $2; c = $3 }
            /atoms$/ && !atoms { atoms = $1 } /[Mm]emory .*Mbytes/ { sub(/.*= */, ""); bytes = $1*1048576 }
            END { if (time == "") exit 1; printf "%s %.5f %.6g %.0f\n", time, touches, kinetic, bytes/(atoms ? atoms : 1) }' \
            $screen >>$out ;;
    *.clumps|*.cubes)
        share=one; [ $code = unshared ] && share=none
        OMP_NUM_THREADS=1 $start build/blocks --raw --scene $scene --steps $steps --warm $WARM --dt $DT --repeat 1 --sharing $share \
            >$screen 2>&1 &&
        awk '$1 == "raw" { print $2, $3, $4, $6, $5; n++ } END { exit !n }' $screen >>$out ;;
    *)
        program=build/bench_$code; [ $code = double ] && program=build/bench
        $start $program --raw --scene $scene --threads $cores --steps $steps --repeat 1 >$screen 2>&1 &&
        awk '$1 == "raw" { print $2, $3, $4, $5; n++ } END { exit !n }' $screen >>$out ;;
    esac || { echo "$scene: $code broke; its output is $screen"; return 1; }
}

# middle of a column of a file of times
middle() { awk -v c=$2 '{ print $c }' "$1" | sort -g | awk '{ v[NR] = $1 } END { print (v[int((NR + 1)/2)] + v[int(NR/2) + 1])/2 }'; }

# middle of the ratios of times, turn by turn, and half their range: what disturbs a turn disturbs both
ratio() { paste -d" " "$1" "$2" | awk '{ print $1/$(NF/2 + 1) }' | sort -g | awk '{ v[NR] = $1 } END {
    m = (v[int((NR + 1)/2)] + v[int(NR/2) + 1])/2; printf "%.2f (+- %.0f %%)", m, 50*(v[NR] - v[1])/m }'; }

load=$(cut -d" " -f1 /proc/loadavg 2>/dev/null)
case $load in ""|0.[0-4]*) ;; *) echo "# load $load: other programs run at the same time" ;; esac
failed=
for cores in $one $two; do
    suffix=; [ $cores = 2 ] && suffix=.threads2
    for scene in $SCENES; do
        others=
        for code in $codes; do
            [ -f bench/peers/${code}_$scene.in ] || [ -f bench/peers/${code}_$scene.py ] && others="$others $code"
        done
        [ "$others" ] || continue
        blocks $scene && [ $cores = 2 ] && continue
        ours="double single"
        case $scene in bed) ours="double single O2" ;; clumps) ours="double unshared" ;; cubes) ours=double ;; esac
        for c in $ours; do
            [ $c = double ] || [ $c = unshared ] || [ -x build/bench_$c ] || ours=$(echo "$ours" | sed "s/ *$c//")
        done
        bad=
        for round in $(seq $ROUNDS); do
            for code in $others $ours; do turn $scene $code $cores || bad="$bad $code"; done
            [ "$bad" ] && break
        done
        [ "$bad" ] && { failed="$failed $scene:$bad"; continue; }
        if blocks $scene; then atoms=1000; else atoms=$(awk '/ atoms$/ { print $1; exit }' $dir/$scene.data); fi
        steps=$(steps_of $scene)
        for code in $others $ours; do
            t=$dir/$scene.$code.$cores.times
            awk -v name="$scene.$code$suffix" -v s=$(middle $t 1) -v n=$atoms -v k=$steps -v c=$(middle $t 2) -v e=$(middle $t 3) \
                -v lo=$(sort -g $t | head -1 | cut -d" " -f1) -v hi=$(sort -g $t | tail -1 | cut -d" " -f1) \
                'BEGIN { printf "# %-26s %7.4g M particle-steps/s (+- %.0f %%)  contacts/bead %.4f  kinetic %.5g J\n",
                    name, 1e-6*n*k/s, 50*(hi - lo)/s, c, e }'
            blocks $scene && echo "#     its middle sank by $(awk -v d=$(middle $t 5) 'BEGIN { printf "%.2f", 1e6*d }') um"
        done
        for code in $ours; do for other in $others; do
            label=$code; [ $code = O2 ] && label=double.O2
            echo "$scene.$label.vs_$other$suffix = $(ratio $dir/$scene.$other.$cores.times $dir/$scene.$code.$cores.times)"
        done; done
        [ $scene$cores = bed1 ] && for code in $others double; do
            echo "bed.$code.memory_per_bead = $(middle $dir/bed.$code.1.times 4) byte"
        done
        # one scene, or not: contacts within 3 % (settling differs by law; of cubes, whose law is another, 20 %), energy within 10 % where it is not a remainder
        for code in $others; do
            awk -v s=$scene -v o=$code -v a=$(middle $dir/$scene.$code.$cores.times 2) -v b=$(middle $dir/$scene.double.$cores.times 2) \
                -v c=$(middle $dir/$scene.$code.$cores.times 3) -v d=$(middle $dir/$scene.double.$cores.times 3) \
                -v far=$([ $scene = cubes ] && echo 0.2 || echo 0.03) -v moves=$(case $scene in drum|gas) echo 1 ;; *) echo 0 ;; esac) 'BEGIN {
                bad = a/b > 1 + far || a/b < 1 - far || (moves && (c/d > 1.1 || c/d < 0.9))
                printf "# %s: %s and dem.h %s\n", s, o, bad ? "ARE NOT ON THE SAME SCENE" : "are on the same scene"
                exit bad }' || failed="$failed $scene:$code"
        done
    done
done
[ "$failed" ] && { echo "failed:$failed"; exit 1; }
exit 0
