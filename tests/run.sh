# sh tests/run.sh FILTER PROGRAM...: runs test programs one after the other and adds up their totals.
# A program that ends without its totals, or badly in spite of them, counts as one failure.
# The last line is "N passed, N failed"; the exit code is 1 when anything failed.
filter=$1; shift
log=$(mktemp) || exit 1
trap 'rm -f "$log"' EXIT
passed=0; failed=0
for program in "$@"; do
    name=$(basename "$program")
    "$program" "$filter" >"$log" 2>&1
    code=$?
    cat "$log"
    totals=$(sed -n "s/^$name: \([0-9]*\) passed, \([0-9]*\) failed\$/\1 \2/p" "$log" | tail -n 1)
    p=${totals% *}; f=${totals#* }
    if [ -z "$totals" ]; then
        p=0; f=1; echo "FAILED $name: ended with code $code before its totals"
    elif [ $code -ne 0 ] && [ "$f" -eq 0 ]; then
        f=1; echo "FAILED $name: ended with code $code after its totals"
    fi
    passed=$((passed + p)); failed=$((failed + f))
done
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
