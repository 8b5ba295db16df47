# sh tests/web.sh DIR [PICTURES]: builds the browser lesson and the law lab into DIR and looks whether they do what C
# does, see tests/web.mjs and tests/lab.mjs. What is not installed is skipped, loudly. Ends with "N passed, N failed", or
# SKIP. Before that the pages that are committed must be those of their sources.
passed=0; failed=0; pages=examples/web/pages; digest=$(sh examples/web/make.sh --digest)
for page in lesson lab; do
    if tail -n 1 $pages/$page.html | grep -q "sources $digest,"; then passed=$((passed + 1))
    else failed=$((failed + 1)); echo "FAILED $pages/$page.html is not that of its sources: make web"; fi
done
end() { echo "$passed passed, $failed failed"; [ $failed = 0 ]; exit $?; }
[ "$1" ] || end
sh examples/web/make.sh "$1"; code=$?
[ $code -eq 77 ] && { echo "SKIP: the pages are not built here"; end; }
[ $code -eq 0 ] || { failed=$((failed + 1)); end; }
command -v node > /dev/null || { echo "SKIP: node not found (Debian package nodejs)"; end; }
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome)
[ -n "$browser" ] || echo "SKIP: no chromium to open the pages in (Debian package chromium)"
# the laws that come with dem.h, and pieces of C, as a C compiler translates them
make -s verdicts > "$1/verdicts.log" || { failed=$((failed + 1)); cat "$1/verdicts.log"; }
${CC:-cc} -std=c99 -O1 -DDEM_NO_OPENMP -DDEM_CORE -ffp-contract=off -c dem.c -o "$1/dem.o" || exit 1
for law in examples/laws/*.h; do
    name=${law##*/}
    ${CC:-cc} -std=c99 -O1 -w -DDEM_NO_OPENMP -DDEM_CORE -ffp-contract=off -DLAW_FILE="\"$PWD/$law\"" examples/web/lab.c "$1/dem.o" \
        -o "$1/lab_${name%.h}" -lm || exit 1
done
printf '#include "%s/tests/lab_subset.h"\n#include <stdio.h>\nint main(void) { int k; for (k = 0; k < CASES; k++) printf("%%.17g\\n", subset(k)); return 0; }\n' \
    "$PWD" > "$1/lab_subset.c"
${CC:-cc} -std=c99 -w "$1/lab_subset.c" -o "$1/lab_subset" -lm || exit 1
for test in web lab; do
    node --no-warnings tests/$test.mjs "$1" $browser $2 > "$1/$test.log"
    cat "$1/$test.log"
    passed=$((passed + $(sed -n 's/^\([0-9]*\) passed, [0-9]* failed$/\1/p' "$1/$test.log" | tail -n 1)))
    tail -n 1 "$1/$test.log" | grep -q ' 0 failed$' || failed=$((failed + 1))
done
end
