# sh tests/run.sh FILTER PROGRAM...: runs test programs, JOBS (1) at a time, and adds up their totals.
# EMULATOR: what runs programs, if not the system. PASSED: a folder that keeps the totals of programs that passed;
# those are not run again.
# A program that ends without its totals, or badly in spite of them, counts as one failure.
# The last line is "N passed, N failed"; the exit code is 1 when anything failed.
if [ "$1" = -one ]; then                       # DIR FILTER NUMBER PROGRAM: output to DIR/NUMBER
    dir=$2; filter=$3; number=$4; program=$5; name=$(basename "$program")
    if [ "$PASSED" ] && [ -f "$PASSED/$name" ]; then cp "$PASSED/$name" "$dir/$number.totals"; exit 0; fi
    began=$(date +%s)
    $EMULATOR "$program" "$filter" >"$dir/$number" 2>&1
    code=$?
    totals=$(sed -n "s/^$name: \([0-9]*\) passed, \([0-9]*\) failed\$/\1 \2/p" "$dir/$number" | tail -n 1)
    p=${totals% *}; f=${totals#* }
    if [ -z "$totals" ]; then
        p=0; f=1; echo "FAILED $name: ended with code $code before its totals" >>"$dir/$number"
    elif [ $code -ne 0 ] && [ "$f" -eq 0 ]; then
        f=1; echo "FAILED $name: ended with code $code after its totals" >>"$dir/$number"
    fi
    echo "$p $f $(($(date +%s) - began)) $name" >"$dir/$number.totals"
    if [ "$PASSED" ] && [ "$f" -eq 0 ]; then cp "$dir/$number.totals" "$PASSED/$name"; fi
    cat "$dir/$number"
    exit 0
fi
filter=$1; shift
export OMP_WAIT_POLICY=passive                # more threads than cores, and more programs: let who waits sleep
dir=$(mktemp -d) || exit 1
trap 'rm -rf "$dir"' EXIT
count=0
for program in "$@"; do count=$((count + 1)); printf '%s\n%s\n' $count "$program"; done |
    xargs -P "${JOBS:-1}" -n 2 sh "$0" -one "$dir" "$filter"
cat "$dir"/*.totals 2>/dev/null | sort -k 3 -n -r | awk '$3 > 9 && NR < 9 { printf("%s%s %d s", (NR > 1 ? ", " : "slowest: "), $4, $3) } END { if (NR) print "" }'
cat "$dir"/*.totals 2>/dev/null | awk -v programs=$# '{ passed += $1; failed += $2 }
    END { failed += programs - NR; print passed + 0 " passed, " failed + 0 " failed"; exit failed > 0 }'
