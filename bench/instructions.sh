# sh bench/instructions.sh [SCENE...]: instructions per body and step in each part of dem.h, counted by callgrind (make
# bench-instructions). SCENE is a name that build/bench --count accepts: bed, an effect on the bed, or walls.KIND. Writes the
# table to build/out/instructions/page.md. The program is compiled for Haswell (AVX2, 2013), because valgrind does not know
# all instructions that -march=native may use. Ten steps are counted. An inlined function counts for the part that calls
# it; parts below 2 % in each column are summed as "other"; in walls.* the counts are divided by the sliding beads.
if ! command -v valgrind > /dev/null 2>&1; then echo "SKIP: valgrind not found (Debian package valgrind)"; exit 0; fi
dir=build/out/instructions
mkdir -p $dir
${CC:-gcc} -g -std=c99 -O3 -march=haswell -fno-math-errno -ffp-contract=off -I. -o $dir/bench bench/bench.c -lm || exit 1
[ "$1" ] || set -- bed all_unlike clusters clusters.members ellipsoids ledger events walls.pair walls.plane walls.mesh_242
for scene in "$@"; do
    valgrind --tool=callgrind --toggle-collect=counted_steps --callgrind-out-file=$dir/$scene.out \
        $dir/bench --count "$scene" --threads 1 > $dir/$scene.log 2>&1 || { cat $dir/"$scene".log; exit 1; }
    { grep '^counted' $dir/"$scene".log; callgrind_annotate --auto=no --threshold=100 $dir/"$scene".out; } > $dir/"$scene".txt || exit 1
done
(cd $dir && awk -v scenes="$*" '
    # which part defines a function: the last definition at the beginning of a line
    FILENAME ~ /dem.h$/ {
        if (ruled && $1 ~ /^>>[a-z]/) part = $1
        ruled = /-----------------------|=======================/
        if (/^[A-Za-z]/ && !/;$/ && match($0, /demi?_[a-z0-9_]+[(,]/)) home[substr($0, RSTART, RLENGTH - 1)] = part
        next
    }
    FNR == 1 { scene = FILENAME; sub(/\.txt$/, "", scene); per = $2*$4; touch[scene] = $6/$4; next }
    /^ *[0-9,]+ \(/ && match($0, /[^ ]+:[A-Za-z_0-9.]+/) {
        count = $1; gsub(/,/, "", count)
        name = substr($0, RSTART, RLENGTH); sub(/.*:/, "", name); sub(/[.].*/, "", name)
        where = name in home ? home[name] : name ~ /^demi_stage_/ ? ">>respond" : "outside dem.h"
        if (where == "" || name == "counted_steps") where = "outside dem.h"
        cost[where, scene] += count/per; all[scene] += count/per; sum[where] += count/per
    }
    END {
        n = split(scenes, s, " ")
        printf "| part of dem.h |"; for (i = 1; i <= n; i++) printf " %s |", s[i]
        printf "\n|---|"; for (i = 1; i <= n; i++) printf "---|"
        for (;;) {                              # parts in falling order
            best = ""
            for (p in sum) if (best == "" || sum[p] > sum[best]) best = p
            if (best == "") break
            for (i = most = 0; i++ < n;) if (cost[best, s[i]] > 0.02*all[s[i]]) most = 1
            delete sum[best]
            if (!most) { for (i = 1; i <= n; i++) rest[i] += cost[best, s[i]]; continue }
            printf "\n| `%s` |", best; for (i = 1; i <= n; i++) printf " %.0f |", cost[best, s[i]]
        }
        printf "\n| other |"; for (i = 1; i <= n; i++) printf " %.0f |", rest[i]
        printf "\n| **sum** |"; for (i = 1; i <= n; i++) printf " **%.0f** |", all[s[i]]
        printf "\n| contacts per body |"; for (i = 1; i <= n; i++) printf " %.2f |", touch[s[i]]
        printf "\n"
    }' ../../../dem.h $(for scene in "$@"; do echo "$scene".txt; done) > page.md) && cat $dir/page.md
