# sh tests/studies.sh [long]: runs every command of the four studies that README.md and docs/*.md name, with --short, JOBS
# at a time. long: runs the commands as they are written, once instead of --repeats times. Those that take an hour stay
# short. A study that a program knows and no page runs is a failure, and so is one that a page names without a command.
# It also checks the rows of docs/seeds*.md (tests/seeds.awk) and, in the short forms, the numbers of tests/studies.txt.
JOBS=${JOBS:-1}
export OMP_WAIT_POLICY=passive   # several programs share the cores: a thread that waits sleeps
dir=build/out/studies
programs="mill screener ellipsoids separator shear triaxial"
pages="README.md docs/*.md"
rm -rf $dir; mkdir -p $dir

# from code blocks, lines that begin with a program; from the text, what stands between backquotes and begins with one
awk -v programs="$programs" '
    BEGIN { gsub(/ /, "|", programs); command = "^build/(" programs ")( |$)" }
    function take(text) { sub(/ +#.*/, "", text); gsub(/^ +| +$/, "", text); if (text ~ command) print text }
    /^(    )?build\// { take($0); next }
    { n = split($0, part, "`"); for (i = 2; i <= n; i += 2) take(part[i]) }' $pages | sort -u > $dir/commands
sed -n 's/.*--study \([a-z]*\).*/\1/p' $dir/commands | sort -u > $dir/run
bad=0
miss() { echo "FAIL  $1"; bad=$((bad + 1)); }
for p in $programs; do
    build/$p --help | sed -n 's/^ *--study WORD *[^:]*: \([^ ]*\) .*/\1/p' | tr '|' '\n' | while read -r word; do
        [ "$word" = run ] || [ "$word" = "$p" ] || grep -q "^build/$p .*--study $word\( \|$\)" $dir/commands ||
            echo "build/$p --study $word: no page gives its command"
    done
done > $dir/missed
grep -ho -- '--study [a-z]*' $pages | sed 's/--study //' | sort -u | while read -r word; do
    grep -qx "$word" $dir/run || echo "--study $word: a page names it, and no page gives its command"
done >> $dir/missed
while read -r line; do miss "$line"; done < $dir/missed
awk -f tests/seeds.awk docs/seeds*.md || miss "docs/seeds*.md: tests/seeds.awk complains"

number=0
while read -r line; do
    number=$((number + 1))
    how=--short
    [ "$1" = long ] && case $line in
        *"--study hour"* | build/ellipsoids*) ;;
        *) how=; line=$(echo "$line" | sed 's/ --repeats [0-9]*//') ;;
    esac
    echo "$line $how --out $dir/$number" | sed 's/  */ /g' > $dir/$number.sh
done < $dir/commands
cat > $dir/one <<'Y'
if sh "$1" > "$1.log" 2>&1; then echo "ok    $(sed 's/ --out.*//' "$1")"; : > "$1.ok"
else echo "FAIL  $(cat "$1")"; grep -v ' %  .*particle-steps/s\| = ' "$1.log" | tail -n 6 | sed 's/^/      | /'; fi
rm -rf "${1%.sh}"
Y
ls $dir/*.sh | xargs -P "$JOBS" -n 1 sh $dir/one

# the numbers of tests/studies.txt, in the logs of all commands that match and have them
: > $dir/missed
[ "$1" = long ] || grep -v '^#' tests/studies.txt | while IFS='|' read -r program words name value tolerance; do
    logs=$(grep -l -- "^build/$program .*$words" $dir/*.sh | sed 's/$/.log/')
    found=$(sed -n "s/^$name = \([^ ]*\).*/\1/p" ${logs:-/dev/null} | sort -u | tr '\n' ' ')
    echo $found | awk -v want="$value" -v by="$tolerance" '
        { good = NF > 0; for (i = 1; i <= NF; i++) good = good && $i/want - 1 < by && $i/want - 1 > -by }
        END { exit !good }' || echo "build/$program $words: $name is '$found', expected $value (tests/studies.txt)"
done > $dir/missed
while read -r line; do miss "$line"; done < $dir/missed
passed=$(ls $dir/*.ok 2>/dev/null | wc -l)
echo "studies: $((passed)) passed, $((number - passed + bad)) failed"
[ "$passed" -eq "$number" ] && [ $bad -eq 0 ]
