# sh bench/rigid.sh: heaps of rigid balls, blocks and rocks (bench/rigid.h) in dem.h, Bullet and ODE. In each round every
# code pours the same heap once, of its own seed, in a process of its own, on processor PROCESSOR. Prints for each scene and
# code the processor time of a step and the kinetic energy that is left (median, smallest, largest), and the speed of dem.h
# over that of the other codes, the median of the ratios of each round. Bullet and ODE are the packages of the distribution;
# the rows tell the size of their reals. A code that is missing is skipped with a line SKIP.
#   SCENES="balls_rigid blocks_rigid rocks_rigid"   ROUNDS=5   BODIES=1000   PROCESSOR=0   SHORT=1 (100 bodies, one round)
[ "$SHORT" ] && { BODIES=${BODIES:-100} ROUNDS=${ROUNDS:-1}; }
ROUNDS=${ROUNDS:-5}
BODIES=${BODIES:-1000}
SCENES=${SCENES:-balls_rigid blocks_rigid rocks_rigid}
SCENES=$(for s in $SCENES; do case $s in (*_rigid) echo $s ;; esac; done)             # others are bench/peers.sh's
[ "$SCENES" ] || exit 0
dir=build/peers
mkdir -p $dir
rm -f $dir/*_rigid.*.raw
found() { command -v "$1" >/dev/null 2>&1; }
pin=; if found taskset; then pin="taskset -c ${PROCESSOR:-0}"; else echo "SKIP: taskset not found, processes may change processors"; fi
[ -x build/rigid ] || { echo "build/rigid is missing: run make bench-peers"; exit 1; }
codes=dem.h
peer() {                                        # NAME PACKAGE
    if found pkg-config && pkg-config --exists $1 && found g++; then
        g++ -O3 -march=native -I. bench/peers/rigid_$1.cpp $(pkg-config --cflags --libs $1) -o $dir/rigid_$1 || exit 1
        codes="$codes $1"
        return
    fi
    echo "SKIP: $1 not found (Debian packages $2, pkg-config, g++): heaps without it" >&2
}
peer bullet libbullet-dev
peer ode libode-dev
# CODE ITERATIONS: what is run, as CODE:ITERATIONS; 0 is the default
runs_of() { for c in $codes; do case $c in dem.h) echo dem.h:0 ;; bullet) echo bullet:20 bullet:50 ;; ode) [ $1 = rocks_rigid ] || echo ode:50 ;; esac; done; }
middle() { awk -v c=$2 '{ print $c }' "$1" | sort -g | awk '{ v[NR] = $1 } END { print (v[int((NR + 1)/2)] + v[int(NR/2) + 1])/2, v[1], v[NR] }'; }
for scene in $SCENES; do
    runs=$(runs_of $scene)
    for round in $(seq $ROUNDS); do
        for run in $runs; do
            case $run in dem.h:*) program=build/rigid ;; *) program=$dir/rigid_${run%:*} ;; esac
            $pin $program $scene $BODIES ${run#*:} $round > $dir/rigid.out && grep '^raw ' $dir/rigid.out >> $dir/$scene.$run.raw ||
                { echo "$scene: $run failed"; exit 1; }
        done
    done
    for run in $runs; do
        raw=$dir/$scene.$run.raw
        awk -v name="$scene.$run" -v t="$(middle $raw 2)" -v c="$(middle $raw 3)" -v e="$(middle $raw 4)" -v h="$(middle $raw 5)" -v s="$(middle $raw 6)" -v o="$(middle $raw 7)" 'BEGIN {
            split(t, v, " "); split(e, k, " "); split(c, n, " "); split(h, z, " "); split(s, w, " "); split(o, p, " ")
            printf "# %-26s a step: median %.4g ms, smallest %.4g, largest %.4g; kinetic energy: median %.2g J/kg, smallest %.2g, largest %.2g; contacts %.0f; height %.3f m; sweeps %.3g; %s %d\n",
                name, v[1]*5, v[2]*5, v[3]*5, k[1], k[2], k[3], n[1], z[1], w[1], name ~ /dem.h/ ? "unsolved" : "bytes of a real", p[1] }'
        [ $run = dem.h:0 ] || echo "$scene.double.vs_$(echo $run | tr : _) = $(paste -d' ' $raw $dir/$scene.dem.h:0.raw | awk '{ print $2/$9 }' |
            sort -g | awk '{ v[NR] = $1 } END { printf "%.3g (%.3g to %.3g, %d rounds)", (v[int((NR + 1)/2)] + v[int(NR/2) + 1])/2, v[1], v[NR], NR }')"
    done
done
