# sh tests/recipes.sh: tests docs/extending.md and docs/extending_*.md. It applies each patch of these pages (```diff) to a
# copy of dem.h and checks that the patch has at most 3 places. Then it applies all of them together and builds
# tests/recipes.c, which uses the additions with spheres, ellipsoids, clusters, digest, checkpoint, slabs, files, replay, report and threads.
# The last line is "N passed, N failed", or SKIP if patch is missing.
CC=${CC:-cc}
dir=build/recipes
command -v patch >/dev/null 2>&1 || { echo "SKIP: patch not found (Debian package patch)"; exit 0; }
rm -rf $dir; mkdir -p $dir/all build/tmp
awk -v dir=$dir '/^```diff$/ { file = sprintf("%s/%d.diff", dir, ++n); inside = 1; next }
    /^```/ { inside = 0 } inside { print > file }' docs/extending.md docs/extending_*.md
# tcc compiles a patched header in 0.1 s; all patches together are compiled by $CC
alone="$CC -fsyntax-only"
if command -v tcc >/dev/null 2>&1; then alone=tcc; fi
passed=0; failed=0
cp dem.h $dir/all/dem.h
for recipe in "$dir"/*.diff; do
    [ -f "$recipe" ] || { echo "FAILED: docs/extending*.md have no recipe"; failed=1; break; }
    places=$(grep -c '^@@' "$recipe")
    if [ "$places" -gt 3 ]; then echo "FAILED $recipe: touches $places places, must be at most 3"; failed=$((failed + 1)); fi
    mkdir -p "${recipe%.diff}"
    cp dem.h "${recipe%.diff}/dem.h"
    for to in "${recipe%.diff}" $dir/all; do
        if ! patch -s --no-backup-if-mismatch "$to/dem.h" "$recipe"; then
            echo "FAILED $recipe: does not apply to dem.h"; failed=$((failed + 1))
        fi
    done
    printf '#define DEM_IMPLEMENTATION\n#include "%s/dem.h"\n' "${recipe%.diff}" > "${recipe%.diff}/dem.c"
    if $alone -std=c99 -Werror -I. -c "${recipe%.diff}/dem.c" -o "${recipe%.diff}/dem.o"; then passed=$((passed + 1))
    else echo "FAILED $recipe: does not compile by itself"; failed=$((failed + 1)); fi
done
if $CC -std=c99 -Werror -I$dir/all -I. tests/recipes.c -o $dir/recipes -lm && $dir/recipes > $dir/log; then :; else failed=$((failed + 1)); fi
cat $dir/log
totals=$(sed -n 's/^recipes: \([0-9]*\) passed, \([0-9]*\) failed$/\1 \2/p' $dir/log)
if [ -z "$totals" ]; then failed=$((failed + 1)); totals="0 0"; fi
echo "$((passed + ${totals% *})) passed, $((failed)) failed"
[ "$failed" -eq 0 ]
