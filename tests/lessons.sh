# sh tests/lessons.sh PROGRAM...: the lessons (build/01_bounce and so on), JOBS (1) at a time. Each runs with --replay in
# build/out/NAME and must end with 0, leave a replay, mark the right answers to its two exercises as right (exit code 0),
# answers that are off by 20 %, 0 or of the other sign as wrong (1), and refuse what makes no sense (2).
# The right answers stand here, worked out by awk and not by the lessons. The last line is "N passed, N failed".
answers() {                                    # NAME: two expressions; tan, asin: see below
    case $1 in
    01_bounce) echo '2*.49^5' '(3*sqrt(9.81/2)-1)/(3*sqrt(9.81/2)+1)' ;;             # h e^(2n); t = sqrt(2 h/g) (1 + e)/(1 - e)
    02_pile) echo 'tan(rad(15))/3' 'tan(asin(3/4)/2)' ;;                                   # half the angle of the normal
    03_incline) echo 'deg(atan2(.35,1))' 'deg(atan2(.6,1))' ;;                             # 7/2 mu; 3 mu
    04_own_law) echo '1/.09' '.64' ;;                                                      # 1/e^2; 1 - e^2
    05_silo) echo '800*9.81*3.14159265/(16*.6*.5)' '1.59362/(4*.4*.5)' ;;                  # rho g pi D^3/(16 mu K); (1-exp(-s))/s = 1/2
    06_hopper) echo '(14.6/6.6)^1.5' '.58*1500*sqrt(9.81)*.0172^2.5' ;;
    07_brazil_nut) echo 'sqrt(9.81/.003)/6.2831853' '1000*.3398369/62.831853' ;;           # A w^2 = g; asin(1/3)/w
    08_drum) echo '60/6.2831853*sqrt(9.81/.5)' '2*9.81*.1*.4244132*.5' ;;                  # w^2 R = g; M g (4 R/3 pi) sin 30
    09_moving_wall) echo '4/(7*.25*9.81)' '.5' ;;                                          # 2 V/(7 mu g); V/3
    10_clusters) echo '(3*.4+2*4)/3' 'deg(atan2(1,2))' ;;                                  # two of three are 2 r off; 4*3/(2*12)
    11_advise) echo '10^.8' '2.87*(1.767^2/(3.6955^2*7.5)*1e-26)^.2*1e6' ;;                # 100^(2/5); m* in 1e-5 kg, E* in 1e10 Pa, R* in 1e-4 m
    12_effects) echo '2.761472' '2/9*2500*9.81*4e-10/1.8e-5' ;;
    *) echo 0 0 ;;
    esac
}
value() {
    awk "function rad(x) { return x*3.14159265358979/180 } function deg(x) { return x*180/3.14159265358979 }
         function tan(x) { return sin(x)/cos(x) } function asin(x) { return atan2(x, sqrt(1 - x*x)) }
         BEGIN { printf \"%.6g\", ($1)*($2) }"
}
now() { date +%s.%N | sed 's/[.]*%*N$//'; }    # s; whole ones where date knows no parts of them
if [ "$1" = -one ]; then                       # DIR PROGRAM
    dir=$2; program=$PWD/$3; name=$(basename "$3"); found=
    wrong() { found="$found; $1"; }
    expect() {                                 # CODE ARGUMENT...
        code=$1; shift
        "$program" "$@" >/dev/null 2>&1
        got=$?
        [ $got -eq "$code" ] || wrong "$* ends with $got instead of $code"
    }
    mkdir -p "build/out/$name"
    cd "build/out/$name" || exit 1
    rm -f "$name.html"
    begun=$(now)
    "$program" --replay >log 2>&1
    code=$?
    ended=$(now)
    times >times                               # of the shell; of what it has run: minutes m seconds s, user and system
    worked=$(awk 'NR == 2 { split($1, t, /[ms]/); print 60*t[1] + t[2] }' times)
    [ $code -eq 0 ] || wrong "ends with code $code"
    [ -s "$name.html" ] || wrong "leaves no replay $name.html"
    expect 0 --help
    expect 2 --movie
    expect 2 --check 1
    expect 2 --check 3 1
    expect 2 --check 1 '12,3'
    exercise=0
    for expression in $(answers "$name"); do
        exercise=$((exercise + 1))
        expect 0 --check $exercise "$(value "$expression" 1)"
        for factor in 0.8 1.2 -1 0; do expect 1 --check $exercise "$(value "$expression" $factor)"; done
    done
    [ $exercise -eq 2 ] || wrong "has $exercise exercises in tests/lessons.sh instead of 2"
    awk -v name="$name" -v found="$found" -v begun="$begun" -v ended="$ended" -v worked="$worked" 'BEGIN {
        printf "%-6s %-16s %5.1f s, %5.1f s of processor time%s\n", found == "" ? "ok" : "FAILED", name, ended - begun, worked,
               found == "" ? "" : ": " substr(found, 3) }' | tee "$dir/$name"
    [ -z "$found" ] || sed 's/^/       | /' log
    exit 0
fi
export OMP_NUM_THREADS=1 OMP_WAIT_POLICY=passive
dir=$(mktemp -d) || exit 1
trap 'rm -rf "$dir"' EXIT
printf '%s\n' "$@" | xargs -P "${JOBS:-1}" -n 1 sh "$0" -one "$dir"
cat "$dir"/* 2>/dev/null | awk -v programs=$# '/^ok/ { passed++ }
    END { print passed + 0 " passed, " programs - passed " failed"; exit passed < programs }'
