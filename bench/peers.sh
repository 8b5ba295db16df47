# sh bench/peers.sh: the scenes of bench/scenes.h, bench/beside.c and bench/blocks.c in dem.h, LAMMPS, LIGGGHTS and YADE,
# from the same start states; in each round every code runs once. A code that is missing is skipped with a line SKIP, and dem.h runs alone.
# Prints for each scene and code the time per step and body (median, smallest, largest), contacts per body, mean overlap and
# kinetic energy; for each pair the speed of dem.h over that of the other code: the median, smallest and largest of the ratios
# of the times of each round; and whether both codes computed the same state.
# On one core, times are processor times (user and system) of the timed steps, so that other programs may run at the same
# time; each run is a separate process, on processor PROCESSOR. CORES=2 or CLOCK=wall: wall time, which needs a quiet
# machine; two cores are two bound threads of dem.h against two bound MPI ranks.
# Inputs are bench/peers/CODE_SCENE.in or .py, with the skin, newton setting and style that made that code fastest. Start
# states of bed, drum, gas, clumps and cubes are in bench/data; build/beside --settle makes those of mixture, clumps3,
# clumps10 and clumps30 (once, minutes). The others read them from build/peers. A code that is compiled for the machine may
# be faster than a distribution's package: name yours with LAMMPS=, LIGGGHTS=, YADE=.
# YADE does one step of cubes in 25, and is given 25 times its time. clumps.unshared is dem.h with
# DEM_CLUSTER_CONTACTS_SEPARATE, the law of the others: every two spheres that touch are a contact. mixture.lammpslaw is
# LAMMPS with the law of dem.h, slower than its style gran/hertz/history. servo_plane and servo_mesh compare dem.h with itself:
# a lid whose motion is set at every step beside the same lid at rest (the code "rest").
#   STEPS=N    steps of bed, drum, clumps; others in proportion       ROUNDS=N    rounds      WARM=500 DT=5e-6  of clumps, cubes
#   CORES="1 2"  SCENES="bed gas"  PROCESSOR=0  CLOCK=wall  LONG=1 (also the million)  SHORT=1 (small scenes, one round)
#   LAMMPS=lmp   LIGGGHTS=liggghts   YADE=yade
brief=; [ "$SHORT" ] && { brief=--short; STEPS=${STEPS:-20} ROUNDS=${ROUNDS:-1} WARM=${WARM:-50} LONG=1; }
ROUNDS=${ROUNDS:-5}
STEPS=${STEPS:-500}
CORES=${CORES:-1}
CLOCK=${CLOCK:-processor}
SCENES=${SCENES:-bed drum mesh gas mixture servo_plane servo_mesh clumps3 clumps10 clumps30 clumps cubes ${LONG:+million}}
SCENES=$(for s in $SCENES; do case $s in (*_rigid) ;; (*) echo $s ;; esac; done)       # those are bench/rigid.sh's
[ "$SCENES" ] || exit 0
WARM=${WARM:-500}
DT=${DT:-5e-6}
LAMMPS=${LAMMPS:-lmp}
LIGGGHTS=${LIGGGHTS:-liggghts}
YADE=${YADE:-yade}
dir=build/peers
mkdir -p $dir
rm -f $dir/*.times $dir/*.out

found() { command -v "$1" >/dev/null 2>&1; }
asked() { for s in $SCENES; do case " $* " in *" $s "*) return 0 ;; esac; done; return 1; }
codes=; suffix_omp=
if found $LAMMPS; then
    codes=lammps
    echo "# $($LAMMPS -h </dev/null 2>/dev/null | awk '/Simulator/ { sub(/.*Simulator - */, "LAMMPS "); print; exit }')"
    # its threaded styles are the faster ones in bed, also on one thread
    $LAMMPS -h </dev/null 2>/dev/null | grep -qw OPENMP && suffix_omp="-sf omp -pk omp 1"
fi
if found $LIGGGHTS; then
    codes="$codes liggghts"
    echo "# $($LIGGGHTS -help </dev/null 2>/dev/null | awk '/LIGGGHTS/ { print; exit }')"
fi
if found $YADE; then
    codes="$codes yade"
    echo "# YADE $($YADE --version 2>&1 </dev/null | awk '/[Vv]ersion/ { print $NF; exit }')"
fi
# has CODE NEEDS: whether it is installed; otherwise a line that cannot be missed
has() {
    case " $codes " in *" $2 "*) return 0 ;; esac
    echo "SKIP: $scene: $2 not found (Debian package $2): no row $scene.$1" >&2
    return 1
}
pin=; if found taskset; then pin="taskset -c ${PROCESSOR:-0}"; else echo "SKIP: taskset not found, processes may change processors"; fi
two=
case " $CORES " in *" 2 "*)
    two=2
    if [ "$(getconf _NPROCESSORS_ONLN 2>/dev/null || echo 1)" -lt 2 ]; then echo "SKIP: one processor, no threads2"; two=
    elif ! found mpirun; then echo "SKIP: mpirun not found (Debian package openmpi-bin), no threads2"; two=; fi
esac
case " $CORES " in *" 1 "*) one=1 ;; *) one= ;; esac
load=$(cut -d" " -f1 /proc/loadavg 2>/dev/null)
case $load in ""|0.[0-4]*) ;; *) echo "# load $load: other programs run at the same time" ;; esac
[ $CLOCK = processor ] && [ "$one" ] && echo "# times on one core are processor times"

built() { [ -x build/$1 ] || { echo "build/$1 is missing: run make bench-peers"; exit 1; }; }
asked bed drum gas mesh million && { built bench; build/bench --codes $dir || exit 1; }
asked clumps cubes && { built blocks; build/blocks --codes $dir || exit 1; }
asked mixture mesh million servo_plane servo_mesh clumps3 clumps10 clumps30 && built beside
spheres_of() { case $1 in clumps) echo 8 ;; clumps*) echo ${1#clumps} ;; esac; }
side_of() { if [ $1 = clumps ]; then echo 0.05; else awk -v n=$(spheres_of $1) -v b=${brief:+100} 'BEGIN { printf "%.12g", 0.05*(n*(b ? b : 1000)/8000)^(1/3) }'; fi; }
# the start state of a scene of build/beside, made if it is not there, and its files for the others
for s in mixture mesh clumps3 clumps10 clumps30; do
    asked $s || continue
    case $s in clumps*) which="clumps --spheres $(spheres_of $s)" ;; *) which=$s ;; esac
    state=build/out/beside/$s${brief:+_short}.txt
    [ $s = mesh ] || { [ -s $state ] && [ ! bench/beside.c -nt $state ]; } || {
        echo "# making the start state of $s"
        build/beside --settle $which $brief > $dir/settle.out 2>&1 || { cat $dir/settle.out; exit 1; }; }
    build/beside --codes $dir --scene $which $brief || exit 1
done
case " $codes " in *" liggghts "*) for s in clumps clumps3 clumps10 clumps30; do
    asked $s && { $LIGGGHTS -in bench/peers/liggghts_clumps_put.in -log none -var data $dir/$s -var side $(side_of $s) \
        >$dir/put.out 2>&1 </dev/null || { echo "$s: liggghts failed; its output is $dir/put.out"; exit 1; }; }
done ;; esac
steps_of() { case $1 in gas) echo $((5*STEPS)) ;; mesh) echo $(((2*STEPS + 4)/5)) ;; servo_mesh) echo $(((STEPS + 4)/5)) ;; million) echo $(((STEPS + 24)/25)) ;; *) echo $STEPS ;; esac; }
warm_of() { case $1 in million) echo 10 ;; mesh) echo 40 ;; clumps*|cubes) echo $WARM ;; *) echo 100 ;; esac; }

# one run: SCENE CODE CORES [check]; appends "seconds contacts kinetic bytes sank overlap" to a file of times. check: runs
# LIGGGHTS once more, with a list of its contacts, for their mean overlap
turn() {
    scene=$1; code=$2; cores=$3; check=${4:+1}; steps=$(steps_of $1); warm=$(warm_of $1); grid="1 1 1"
    if [ $cores = 2 ]; then grid="2 1 1"; [ $scene = drum ] && grid="1 2 1"; fi
    screen=$dir/$scene.$code.$cores.out
    out=$dir/$scene.$code.$cores${4:+.check}.times
    start=$pin; [ $cores = 2 ] && start="env OMP_PROC_BIND=true OMP_PLACES=cores"
    wall=; { [ $cores = 2 ] || [ $CLOCK = wall ]; } && wall=1
    cpu=--cpu; [ "$wall" ] && cpu=
    list=$dir/$scene.$code.contacts
    case $code.$scene in
    yade.*)
        part=1; [ $scene = cubes ] && part=25
        OMP_NUM_THREADS=1 $start $YADE -j 1 -n -x bench/peers/yade_$scene.py $dir/$scene.txt $(((steps + part - 1)/part)) \
            $((warm/part)) $DT >$screen 2>&1 </dev/null
        awk -v all=$steps -v done=$(((steps + part - 1)/part)) \
            '$1 == "raw" { print $2*all/done, $3, $4, $6, $5, 0; n++ } END { exit !n }' $screen >>$out ;;
    lammps*.*|liggghts.*)
        program=$LIGGGHTS; options=; input=${code}_$scene; data=$dir/$scene.data; half=1
        case $code in lammps*) program=$LAMMPS ;; esac
        case $scene in
        bed) [ $code = lammps ] && options=$suffix_omp ;;
        mixture) input=lammps_mixture; options="-var side $(awk -v b=$brief 'BEGIN { print b ? 0.016 : 0.032 }') -var law $([ $code = lammps ] && echo hertz || echo material)" ;;
        million) input=lammps_bed; data=$dir/bed.data; options="$suffix_omp -var tiles $([ $brief ] && echo 1 || echo 7)" ;;
        mesh) input=liggghts_drum; data=$dir/drum.data ;;
        clumps*) input=liggghts_clumps; data=$dir/$scene; half=$(spheres_of $scene)
            options="-var side $(side_of $scene) -var dt $DT -var damping $(awk -v n=$half 'BEGIN { print 7911*sqrt(8/n) }')" ;;
        esac
        stl=$dir/drum.stl; [ $scene = mesh ] && stl=$dir/mesh.stl
        [ $cores = 2 ] && start="mpirun --allow-run-as-root --oversubscribe --bind-to core -np 2"
        rm -f $list
        set -- $grid
        OMP_NUM_THREADS=1 $start $program $options -in bench/peers/$input.in -log none -var data $data -var stl $stl -var warm $warm \
            -var steps $steps -var px $1 -var py $2 -var pz $3 -var check ${check:-0} -var contacts $list >$screen 2>&1 </dev/null
        # the timed loop: its time, and the line of numbers after it; the first such line has the height at the start
        awk -v wall=$wall -v part=$half -v list=$list -v scene=$scene '
            /^processor [0-9]+ *$/ { if (spent) { time = ($2 - spent)*1e-9; k = c = ""; waits = 1 } spent = $2 }
            /^Loop time/ { loop[++loops] = $4 }
            (NF == 3 || NF == 4) && $1 ~ /^[0-9]+$/ { if (!rows[$1]++) { last = $1; kinetic = $2; touches = $3; high[++n] = $4 } }
            /atoms$/ && !atoms { atoms = $1 } /[Mm]emory .*Mbytes/ { sub(/.*= */, ""); bytes = $1*1048576 }
            END {
                if (wall) time = loop[2]
                if (time == "" || n < 3) exit 1
                while ((getline line < list) > 0) { f = split(line, v, " ")
                    if (line ~ /^ITEM: ENTRIES/) { on = 1; continue }
                    if (line ~ /^ITEM/) on = 0
                    if (!on) continue
                    d = f == 1 && scene != "bed" && scene != "million" ? v[1] : \
                        f == 1 ? 0.003 - v[1] : (v[1] + v[2] == 2 ? 0.0005 : v[1] + v[2] == 3 ? 0.00275 : 0.005) - v[3]
                    if (d > 0) { sum += d; many++ } }
                printf "%s %.5f %.6g %.0f %.6g %.6g\n", time, touches*(part > 1 ? part/2 : 1), kinetic,
                    bytes/(atoms ? atoms : 1), high[1] - high[n], many ? sum/many : 0 }' $screen >>$out ;;
    *.clumps|*.cubes)
        share=one; [ $code = unshared ] && share=none
        OMP_NUM_THREADS=1 $start build/blocks --raw --scene $scene --steps $steps --warm $warm --dt $DT --repeat 1 --sharing $share \
            >$screen 2>&1 &&
        awk '$1 == "raw" { print $2, $3, $4, $6, $5, 0; n++ } END { exit !n }' $screen >>$out ;;
    *.mixture|*.mesh|*.million|*.servo_*|*.clumps*)
        options="--scene $scene"
        case $scene in
        servo_*) options="--scene servo --lid ${scene#servo_}"; [ $code = rest ] || options="$options --servo" ;;
        clumps*) options="--scene clumps --spheres $(spheres_of $scene) --contacts $([ $code = unshared ] && echo separate || echo merged)" ;;
        esac
        OMP_NUM_THREADS=1 $start build/beside $options --steps $steps --warm $warm $brief >$screen 2>&1 &&
        awk '$1 == "raw" { print $2, $3, $4, $5, $6, $7, $8; n++ } END { exit !n }' $screen >>$out ;;
    *)
        program=build/bench_$code; [ $code = double ] && program=build/bench
        $start $program --raw $cpu --scene $scene --threads $cores --steps $steps --repeat 1 >$screen 2>&1 &&
        awk '$1 == "raw" { print $2, $3, $4, $5, 0, 0; n++ } END { exit !n }' $screen >>$out ;;
    esac || { echo "$scene: $code failed; its output is $screen"; return 1; }
}

# middle, smallest and largest of a column of a file of times
middle() { awk -v c=$2 '{ print $c }' "$1" | sort -g | awk '{ v[NR] = $1 } END { print (v[int((NR + 1)/2)] + v[int(NR/2) + 1])/2, v[1], v[NR] }'; }

# of the ratios of the times of each round: what disturbs a round disturbs both
ratio() { paste -d" " "$1" "$2" | awk '{ print $1/$('$(awk '{ print NF + 1; exit }' "$1")') }' | sort -g |
    awk '{ v[NR] = $1 } END { printf "%.3g (%.3g to %.3g, %d rounds)", (v[int((NR + 1)/2)] + v[int(NR/2) + 1])/2, v[1], v[NR], NR }'; }

failed=
for cores in $one $two; do
    suffix=; [ $cores = 2 ] && suffix=.threads2
    for scene in $SCENES; do
        others=; ours=double
        case $scene in
        bed) has lammps lammps && others=lammps; has liggghts liggghts && others="$others liggghts"; ours="double single O2" ;;
        drum) has liggghts liggghts && others=liggghts; ours="double single" ;;
        gas) has lammps lammps && others=lammps; ours="double single" ;;
        mesh) has liggghts liggghts && others=liggghts ;;
        million) has lammps lammps && others=lammps ;;
        mixture) has lammps lammps && others="lammps lammpslaw" ;;
        servo_*) others=rest ;;
        clumps) has liggghts liggghts && others=liggghts; has yade yade && others="$others yade"; ours="double unshared" ;;
        clumps*) has liggghts liggghts && others=liggghts; ours="double unshared" ;;
        cubes) has yade yade && others=yade ;;
        *) echo "no scene $scene"; exit 1 ;;
        esac
        case $scene in bed|drum|gas) ;; *) [ $cores = 2 ] && continue ;; esac
        for c in $ours; do
            case $c in single|O2) [ -x build/bench_$c ] || { echo "SKIP: build/bench_$c is missing (make bench-peers builds it)"; ours=$(echo "$ours" | sed "s/ *$c//"); } ;; esac
        done
        bad=
        for round in $(seq $ROUNDS); do
            for code in $others $ours; do turn $scene $code $cores || bad="$bad $code"; done
            [ "$bad" ] && break
        done
        [ "$bad" ] && { failed="$failed $scene:$bad"; continue; }
        steps=$(steps_of $scene)
        case $scene in clumps|cubes) bodies=1000 ;; bed|drum|gas) bodies=$(awk '/ atoms$/ { print $1; exit }' $dir/$scene.data) ;;
            *) bodies=$(awk '{ print $7; exit }' $dir/$scene.double.$cores.times) ;; esac
        for code in $others $ours; do
            t=$dir/$scene.$code.$cores.times
            overlap=$(middle $t 6 | cut -d" " -f1)
            case $code.$scene in liggghts.drum|liggghts.mesh|liggghts.clumps?*) [ $cores = 1 ] && turn $scene $code $cores check &&
                overlap=$(cut -d" " -f6 $dir/$scene.$code.1.check.times) ;; esac
            echo $overlap > $dir/$scene.$code.overlap
            awk -v name="$scene.$code$suffix" -v s="$(middle $t 1)" -v n=$bodies -v k=$steps -v c="$(middle $t 2)" -v e="$(middle $t 3)" \
                -v rounds=$ROUNDS -v o=$overlap -v d="$(middle $t 5)" 'BEGIN { split(s, v, " "); f = 1e9/n/k
                printf "# %-24s ns per step and body: median %.4g, smallest %.4g, largest %.4g; rounds %d; contacts/body %.4f; overlap %.4g um; kinetic %.4g J; sank %.3g um\n",
                    name, f*v[1], f*v[2], f*v[3], rounds, c, 1e6*o, e, 1e6*d }'
        done
        for code in $ours; do for other in $others; do
            label=$code; [ $code = O2 ] && label=double.O2
            echo "$scene.$label.vs_$other$suffix = $(ratio $dir/$scene.$other.$cores.times $dir/$scene.$code.$cores.times)"
        done; done
        [ $scene$cores = bed1 ] && for code in $others double; do
            echo "bed.$code.memory_per_bead = $(middle $dir/bed.$code.1.times 4 | cut -d" " -f1) byte"
        done
        # the same state, or not: contacts and mean overlap within 3 % (8 % in mixture, whose small spheres still shift; 20 %
        # of cubes, whose law is another), and the
        # energy within 10 % where bodies move. Of clumps with separate contacts, as in the other codes
        like=double; case $ours in *unshared*) like=unshared ;; esac
        for code in $others; do
            awk -v s=$scene -v o=$code -v a="$(middle $dir/$scene.$code.$cores.times 2)" -v b="$(middle $dir/$scene.$like.$cores.times 2)" \
                -v c="$(middle $dir/$scene.$code.$cores.times 3)" -v d="$(middle $dir/$scene.$like.$cores.times 3)" \
                -v p=$(cat $dir/$scene.$code.overlap) -v q=$(cat $dir/$scene.$like.overlap) \
                -v far=$(if [ $scene = cubes ]; then echo 0.2; elif [ $brief ]; then echo 0.1; elif [ $scene = mixture ]; then echo 0.08; else echo 0.03; fi) -v moves=$(case $scene in drum|mesh|gas) echo 1 ;; *) echo 0 ;; esac) 'BEGIN {
                a += 0; b += 0; c += 0; d += 0; both = p > 0 && q > 0
                bad = a/b > 1 + far || a/b < 1 - far || (both && (p/q > 1 + far || p/q < 1 - far)) || (moves && (c/d > 1.1 || c/d < 0.9))
                printf "# %s: %s and dem.h %s: contacts %.4f and %.4f%s, kinetic energy %.4g and %.4g J\n", s, o,
                    bad ? "ARE NOT IN THE SAME STATE" : "are in the same state", a, b,
                    both ? sprintf(", overlap %.4g and %.4g um", 1e6*p, 1e6*q) : "", c, d
                exit bad }' || failed="$failed $scene:$code"
        done
    done
done
[ "$failed" ] && { echo "failed:$failed"; exit 1; }
exit 0
