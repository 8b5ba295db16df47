# sh tests/lessons.sh PROGRAM...: the lessons (build/01_bounce and so on), JOBS (1) at a time. Each runs with --replay in
# build/out/NAME and must end with 0, leave a replay, mark the right answers to its two exercises as right (exit code 0),
# answers that are off by 20 %, 0 or of the other sign as wrong (1), and refuse what makes no sense (2). The same holds for
# the exercises that --seed prints for a name. The test reads their numbers from the text.
# The right answers stand here, worked out by awk and not by the lessons. The last line is "N passed, N failed".
answers() {                                    # NAME: for both exercises the numbers of the text without a name, and the answer
    case $1 in
    01_bounce) echo '.7,2 x2*x1^10' '1,3 (x2*sqrt(9.81/2/x1)-1)/(x2*sqrt(9.81/2/x1)+1)' ;;  # h e^(2n); t = sqrt(2 h/g) (1 + e)/(1 - e)
    02_pile) echo '1 tan(rad(15))*x1/(2+x1)' '1 tan(asin(.5+x1/4)/2)' ;;                    # T = f W/2 tan 15, floor W + f W/2; half the angle of the normal
    03_incline) echo '.1 deg(atan2(3.5*x1,1))' '.2 deg(atan2(3*x1,1))' ;;                   # 7/2 mu; 3 mu
    04_own_law) echo '.3 1/x1^2' '.6 1-x1^2' ;;                                             # 1/e^2; 1 - e^2
    05_silo) echo '1,800,.5,.6 x2*9.81*3.14159265*x1^3/(16*x4*x3)' '.4,.5 1.59362/(4*x1*x2)' ;;    # rho g pi D^3/(16 mu K); (1-exp(-s))/s = 1/2
    06_hopper) echo '1.4,16,8 ((x2-x1)/(x3-x1))^1.5' '20,2,1500,.58,1.4 x4*x3*sqrt(9.81)*((x1-x5*x2)/1000)^2.5' ;;
    07_brazil_nut) echo '3 sqrt(9810/x1)/6.2831853' '3,10 1000*asin(1/x1)/(6.2831853*x2)' ;;    # A w^2 = g; asin(1/Gamma)/w
    08_drum) echo '1 60/6.2831853*sqrt(9.81/(x1/2))' '.1,2,30 x2*9.81*x1*.4244132*sin(rad(x3))' ;; # w^2 R = g; M g (4 R/3 pi) sin 30
    09_moving_wall) echo '2,.25 2*x1/(7*x2*9.81)' '1.5 x1/3' ;;                             # 2 V/(7 mu g); V/3
    10_clusters) echo '3 row(x1)' '3,12 deg(atan2(2*x1,x2))' ;;                             # H = 4 z, L = 2 r
    11_advise) echo '100 x1^.4' '3,2500,70,.23,1 hertz(x1/2000,x2,x3*1e9,x4,x5)*1e6' ;;
    12_effects) echo '1.84,1.34,1.12 x1*x2*x3' '2500,20 2/9*x1*9.81*x2^2*1e-12/1.8e-5' ;;
    *) echo '0 0' '0 0' ;;
    esac
}
value() {                                      # NUMBERS FORMULA FACTOR
    awk -v numbers="$1" "function rad(x) { return x*3.14159265358979/180 } function deg(x) { return x*180/3.14159265358979 }
         function tan(x) { return sin(x)/cos(x) } function asin(x) { return atan2(x, sqrt(1 - x*x)) }
         function row(n,  i, sum) {            # spheres of radius 1: 2/5 and the squared distances from the middle
             for (i = 1; i <= n; i++) sum += (2*i - n - 1)^2
             return .4 + sum/n
         }
         function hertz(r, rho, young, nu, v,  m, e) {
             m = 4/3*3.14159265*r^3*rho/2; e = young/(1 - nu^2)/2
             return 2.87*exp(log(m^2/(e^2*r/2*v))/5)
         }
         BEGIN { split(numbers, x, \",\"); x1 = x[1]; x2 = x[2]; x3 = x[3]; x4 = x[4]; x5 = x[5]; printf \"%.6g\", ($2)*($3) }"
}
numbers() {                                    # EXERCISE FILE: all numbers of its text as --seed prints it, with commas
    awk -v exercise="$1" '/^[12]  / { on = $1 == exercise; $1 = "" } !/^ / { on = 0 }
        on { for (i = 1; i <= NF; i++) { gsub(/[(]|[.,:;)?]+$/, "", $i)
                                         if ($i ~ /^[0-9]+([.][0-9]+)?$/) { printf "%s%s", sep, $i; sep = "," } } }' "$2"
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
    mark() {                                   # FACTORS NUMBERS FORMULA ARGUMENT...: right as it is, wrong with any of FACTORS
        factors=$1; numbers=$2; formula=$3; shift 3
        expect 0 "$@" "$(value "$numbers" "$formula" 1)"
        for factor in $factors; do expect 1 "$@" "$(value "$numbers" "$formula" "$factor")"; done
    }
    expect 2 --seed
    expect 2 --seed ''
    expect 2 --seed ' -'
    expect 2 --seed --check 1 1
    expect 2 --seed Ada --replay
    expect 2 --replay --seed Ada
    expect 2 --seed Ada --check
    expect 2 --seed Ada --check 3 1
    set -f
    set -- $(answers "$name")                  # NUMBERS FORMULA NUMBERS FORMULA
    [ $# -eq 4 ] || wrong "has $# words in tests/lessons.sh instead of 4"
    for exercise in 1 2; do
        mark '0.8 1.2 -1 0' "$1" "$2" --check $exercise
        count=$(echo "$1" | tr , '\n' | wc -l); accepted=0; pairs=0; others=
        for student in Ada Bob 'Grace Hopper' 'J\303\274rgen' Eve Lin Max Zoe; do
            student=$(printf "$student")
            "$program" --seed "$student" > seeded 2>&1 || wrong "--seed $student fails"
            "$program" --seed "$student" | cmp -s - seeded || wrong "--seed $student prints other numbers the second time"
            ! grep -q '[{}]' seeded || wrong "--seed $student prints a brace"
            drawn=$(numbers $exercise seeded | cut -d, -f "1-$count")
            [ "$(echo "$drawn" | tr , '\n' | wc -l)" -eq "$count" ] || wrong "--seed $student prints $drawn in exercise $exercise"
            mark '0.8 1.2' "$drawn" "$2" --seed "$student" --check $exercise
            for other in $others; do           # answers of those before
                pairs=$((pairs + 1))
                "$program" --seed "$student" --check $exercise "$other" > seeded && accepted=$((accepted + 1))
            done
            others="$others $(value "$drawn" "$2" 1)"
        done
        [ $((4*accepted)) -lt "$pairs" ] || wrong "exercise $exercise: answers of others are right in $accepted of $pairs pairs of names"
        shift 2
    done
    "$program" --seed 'Grace Hopper' | sed 's/Grace Hopper//' > seeded
    "$program" --seed ' grace_HOPPER ' | sed 's/ grace_HOPPER //' | cmp -s - seeded || wrong "case, blanks or _ of a name change its numbers"
    if [ "$name" = 05_silo ]; then             # numbers of a name are the same on every machine and in every version
        "$program" --seed Ada > seeded; drawn=$(numbers 1 seeded)
        [ "$drawn" = 0.9,870,0.4,0.55 ] || wrong "--seed Ada prints $drawn in exercise 1"
    fi
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
