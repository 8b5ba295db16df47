# sh examples/marks.sh DIR DEM.o: examines the work of a class and writes DIR/marks.csv. `make marks DIR=folder` calls it.
#   DIR/NAME.h        a contact law of the student NAME with its row LAW (docs/laws.md), as the law lab saves it: one point for
#                     each line of the exam that it passes, but for "quick"
#   DIR/answers.txt   lines "NAME LESSON EXERCISE VALUE", for example "Ada 05_silo 1 5136": one point for a right answer.
#                     With SEEDS=1 the numbers of the exercise are those of NAME (build/05_silo --seed Ada).
#                     NAME has no blank; Ada_Lovelace has the numbers of "Ada Lovelace"
# Columns of marks.csv: student, task, result, points, of, found. A law that crashes, does not end, ends the program or does
# not compile gets 0 points and says why. Each law has LIMIT seconds (60) to compile, and 20 for a line of the exam.
# The last line is "N marked"; the exit code is 0 unless nothing was found to mark.
dir=${1%/}; object=$2; limit=${LIMIT:-60}; lines=16; here=$(cd "$(dirname "$0")" && pwd)
[ -d "$dir" ] || { echo "marks: there is no folder \"$dir\": write make marks DIR=folder"; exit 2; }
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
within() { if command -v timeout > /dev/null; then timeout "$@"; else shift; "$@"; fi; }      # SECONDS COMMAND...
row() {                                        # STUDENT TASK RESULT POINTS OF FOUND
    printf '%s,%s,%s,%s,%s,"%s"\n' "$1" "$2" "$3" "$4" "$5" "$(printf '%s' "$6" | tr '"\n' "' ")" >> "$work/marks.csv"
    printf '%-20s %-16s %-24s %2s of %-2s %s\n' "$1" "$2" "$3" "$4" "$5" "$6" | cut -c 1-160
}
echo "student,task,result,points,of,found" > "$work/marks.csv"
for law in "$dir"/*.h; do
    [ -f "$law" ] || continue
    student=$(basename "$law" .h); file=$(cd "$dir" && pwd)/$student.h
    if ! within "$limit" ${CC:-cc} -O1 -w -I"$here/.." -DLAW_FILE="\"$file\"" "$here/exam.c" "$object" -o "$work/exam" ${LINK:--lm} > "$work/log" 2>&1; then
        row "$student" law "does not compile" 0 $lines "$(grep -m 1 'error: ' "$work/log" | sed 's/^.*error: //')"
        continue
    fi
    within $((25*lines)) "$work/exam" --out "$work" > "$work/log" 2>&1 < /dev/null; code=$?
    points=$(grep -v '^passed  quick' "$work/log" | grep -c '^passed  ')
    found=$(sed -n 's/^FOUND   \(.*[^ ]\)   *\(.*\)/\1: \2/p' "$work/log" | grep -v '^quick' | tr '\n' ';' | sed 's/;$//; s/;/; /g')
    if grep -q 'the exam ended at this line' "$work/log" || [ $code -gt 1 ]; then row "$student" law "stopped" 0 $lines "${found:-exit code $code}"
    elif [ $code -eq 0 ] && [ "$points" -eq $lines ]; then row "$student" law passed $lines $lines ""
    else row "$student" law "found" "$points" $lines "$found"
    fi
done
[ ! -f "$dir/answers.txt" ] || while read -r student lesson exercise value rest; do
    case $student in ''|\#*) continue;; esac
    case $lesson in [0-9][0-9]_[a-z_]*) program=build/$lesson;; *) program=;; esac
    if [ -z "$program" ] || [ ! -x "$program" ] || [ "$rest" ]; then row "$student" "$lesson $exercise" "not understood" 0 1 "a line has NAME LESSON EXERCISE VALUE"; continue; fi
    within "$limit" "$program" ${SEEDS:+--seed "$student"} --check "$exercise" "$value" > "$work/log" 2>&1 < /dev/null
    case $? in
    0) row "$student" "$lesson $exercise" right 1 1 "$value" ;;
    1) row "$student" "$lesson $exercise" wrong 0 1 "$value" ;;
    *) row "$student" "$lesson $exercise" "not understood" 0 1 "$(head -n 1 "$work/log")" ;;
    esac
done < "$dir/answers.txt"
marked=$(($(wc -l < "$work/marks.csv") - 1))
[ $marked -gt 0 ] || { echo "marks: $dir has neither laws (NAME.h) nor answers.txt"; exit 2; }
mv "$work/marks.csv" "$dir/marks.csv.part" && mv "$dir/marks.csv.part" "$dir/marks.csv" || exit 1
echo "$dir/marks.csv: $marked marked"
