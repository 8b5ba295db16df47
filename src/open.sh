# sh src/open.sh DIR: the rooms of dem.h as sources that are compiled separately, for the tests and for whoever edits.
# DIR/FOLDER.c is the folder src/FOLDER with all its functions visible, after what the folders above it declare;
# DIR/private.h declares everything. Files that are as they were keep their time, so that make compiles only what an
# edit changes. SWITCH=-DDEM_NO_SLABS: only the rooms that are left then. OPEN_LINES=1: inline functions also have file and
# line in src/, which tests/coverage.sh counts by.
dir=$1
mkdir -p "$dir"
keep() { cmp -s "$dir/new" "$1" || cp "$dir/new" "$1"; }
rooms=$(sed -n 's/^#include "\([a-z]*\/.*\)"/src\/\1/p' src/dem.h)
[ -z "$SWITCH" ] || rooms=$({ ${CC:-cc} $SWITCH -E -dM src/api/api.h | grep '^#define DEM_NO_'
    sed -n '/^#ifndef DEM_NO_/p; /^#endif .. DEM_NO_/p; s/^#include "\([a-z]*\/.*\)"/src\/\1/p' src/dem.h; } | ${CC:-cc} -E -P -)
{
    echo '#ifndef DEM_H'; echo '#define DEM_H'
    for room in $rooms; do case $room in src/api/manual.h) ;; src/api/*) [ -z "$OPEN_LINES" ] || echo "#line 1 \"$room\""; cat "$room" ;; esac; done
    echo '#endif'; echo '#define DEM_IMPLEMENTATION'; echo '#define DEM_IMPLEMENTATION_DONE'
} > "$dir/above"
for folder in $(for room in $rooms; do basename "$(dirname "$room")"; done | uniq | grep -vx api); do
    these=$(for room in $rooms; do case $room in src/$folder/*) echo "$room" ;; esac; done)
    { cat "$dir/above"; awk -f src/open.awk $these; } > "$dir/new" && keep "$dir/$folder.c" || exit 1
    awk -v declare=1 -v lines="$OPEN_LINES" -f src/open.awk $these >> "$dir/above" || exit 1
done
cp "$dir/above" "$dir/new" && keep "$dir/private.h"
rm "$dir/above" "$dir/new"
