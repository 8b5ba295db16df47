# sh tests/lessons.sh PROGRAM...: the lessons (build/01_bounce and so on), JOBS (1) at a time. Each runs with --replay in
# build/out/NAME and must end with 0, leave a replay, mark the right answers to its two exercises as right (exit code 0),
# answers that are off by 20 %, 0 or of the other sign as wrong (1), and refuse what makes no sense (2). The same holds for
# the numbers of four names, which --seed prints.
# The right answers stand here, worked out by awk and not by the lessons. The last line is "N passed, N failed".
answers() {                                    # NAME: two expressions of the numbers x1, x2 ... of an exercise
    case $1 in
    01_bounce) echo 'x2*x1^10' '(x2*sqrt(9.81/(2*x1))-1)/(x2*sqrt(9.81/(2*x1))+1)' ;;         # h e^(2n); t = sqrt(2 h/g) (1 + e)/(1 - e)
    02_pile) echo 'tan(rad(15))*x1/(x1+2)' 'tan(asin((2+x1)/4)/2)' ;;                         # N = 1 + x/2, H = x/2 tan 15; half the angle of the normal
    03_incline) echo 'deg(atan2(3.5*x1,1))' 'deg(atan2(3*x1,1))' ;;                           # 7/2 mu; 3 mu
    04_own_law) echo '1/x1^2' '1-x1^2' ;;
    05_silo) echo 'x2*9.81*3.14159265*x1^3/(16*x4*x3)' '1.59362/(4*x1*x2)' ;;                 # rho g pi D^3/(16 mu K); (1-exp(-s))/s = 1/2
    06_hopper) echo '((x1-1.4)/(x2-1.4))^1.5' '.58*x3*sqrt(9.81)*((x1-1.4*x2)/1000)^2.5' ;;
    07_brazil_nut) echo 'sqrt(9.81/(x1/1000))/6.2831853' '1000*asin(1/x1)/(6.2831853*x2)' ;;  # A w^2 = g; asin(1/Gamma)/w
    08_drum) echo '60/6.2831853*sqrt(2*9.81/x1)' 'x2*9.81*x1*.4244132*sin(rad(x3))' ;;        # w^2 R = g; M g (4 R/3 pi) sin
    09_moving_wall) echo '2*x1/(7*x2*9.81)' 'x1/3' ;;                                         # 2 V/(7 mu g); V/3
    10_clusters) echo 'row(x1)' 'deg(atan2(2*x1,x2))' ;;                                      # each .4, and its distance squared; 4 z/(2 r)
    11_advise) echo 'x1^.4' 'hertz(x1/2000,x2)' ;;
    12_effects) echo 'x1*x2*x3' '2/9*2500*9.81*x1^2*1e-12/1.8e-5' ;;
    *) echo 0 0 ;;
    esac
}
defaults() {                                   # NAME: the numbers of both exercises without --seed, separated by commas
    case $1 in
    01_bounce) echo .7,2 1,3 ;; 02_pile) echo 1 1 ;; 03_incline) echo .1 .2 ;; 04_own_law) echo .3 .6 ;;
    05_silo) echo 1,800,.5,.6 .4,.5 ;; 06_hopper) echo 16,8 20,2,1500 ;; 07_brazil_nut) echo 3 3,10 ;;
    08_drum) echo 1 .1,2,30 ;; 09_moving_wall) echo 2,.25 1.5 ;; 10_clusters) echo 3 3,12 ;; 11_advise) echo 100 3,1 ;;
    12_effects) echo 1.84,1.34,1.12 20 ;;
    esac
}
value() {                                      # EXPRESSION FACTOR NUMBERS: hertz: 2.87 (m*^2/(R* E*^2 v))^.2 in us, of two glass beads
    awk -v numbers="$3" "function rad(x) { return x*3.14159265358979/180 } function deg(x) { return x*180/3.14159265358979 }
         function tan(x) { return sin(x)/cos(x) } function asin(x) { return atan2(x, sqrt(1 - x*x)) }
         function row(n,   i, sum) { for (i = 1; i <= n; i++) sum += .4 + (2*i - n - 1)^2; return sum/n }
         function hertz(R, v,   m, E) { m = 2500*4.18879*R^3/2; E = 70e9/2/(1 - .23^2); return 2.87e6*(m^2/(R/2*E^2*v))^.2 }
         BEGIN { n = split(numbers, x, \",\"); x1 = x[1] + 0; x2 = x[2] + 0; x3 = x[3] + 0; x4 = x[4] + 0; printf \"%.6g\", ($1)*($2) }"
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
    marks() {                                  # NUMBERS NUMBERS ARGUMENT...: the right answers to both exercises, and wrong ones
        numbers="$1 $2"; shift 2
        exercise=0
        for expression in $(answers "$name"); do
            exercise=$((exercise + 1))
            given=$(echo "$numbers" | cut -d ' ' -f $exercise)
            expect 0 "$@" --check $exercise "$(value "$expression" 1 "$given")"
            for factor in 0.8 1.2 -1 0; do expect 1 "$@" --check $exercise "$(value "$expression" $factor "$given")"; done
        done
    }
    numbers() { "$program" --seed "$1" | sed -n 's/^ *numbers: //p' | tr ' \n' ', ' | sed 's/ $//'; }
    expect 2 --seed
    expect 2 --seed ' '
    expect 2 --seed Ada --replay
    expect 2 --seed Ada --check 1
    [ "$(numbers 'Ada Lovelace')" = "$(numbers ada_lovelace)" ] || wrong "the same name gets two sets of numbers"
    [ "$(numbers Ada)" != "$(numbers Bob)" ] || wrong "two names get the same numbers"
    for student in Ada Bob 'Ada Lovelace' 'Jörg 7'; do marks $(numbers "$student") --seed "$student"; done
    marks $(defaults "$name")
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
