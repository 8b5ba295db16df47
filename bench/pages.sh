# sh bench/pages.sh [effects] [accuracy] [roofline] [clusters] [shapes] [screener] [peers] [peers_two] [blocks] [ellipsoids]
#                   [instructions] [lessons] [heap]
# Measures again and replaces tables and pictures in docs/ (without arguments: effects, accuracy, roofline, clusters).
#   effects     what effects cost, in accuracy.md and README.md
#   screener    times of the screener, in screener.md
#   peers       the table of README.md and the one in peers.md
#   peers_two   two cores beside other codes, in peers.md
#   blocks      beds of blocks beside other codes, in shapes.md
#   ellipsoids  Table 2 in ellipsoids.md, and the theory in docs/data
#   instructions  instructions of each part of dem.h, in roofline.md; needs no quiet machine
#   lessons     what the twelve lessons print, in teaching.md
#   heap        what the program in README.md prints
#   others      the page of the same name
# Tables are between <!-- NAME: begin --> and <!-- NAME: end -->. Each bench writes its own as page.md; full tables go to
# docs/data. Needs a quiet machine: a page that was measured on a busy one begins with <!-- busy --> and is not copied.
# lessons and heap need none (make pages).
# Below the begin of a block a stamp says how its figures were measured, and on which code (bench/figures.txt, bench/code.sh):
#   <!-- NAME: COMMAND; PROCESSOR; commit HASH; code PARTS DIGESTS -->
# A table in docs/data has the same in its first line: # COMMAND; PROCESSOR; commit HASH; code PARTS DIGESTS
[ "$1" ] || set -- effects accuracy roofline clusters
export OMP_PROC_BIND=true OMP_PLACES=cores
# the code before anything runs: what the programs were built from
sh bench/code.sh > build/code.begun || exit 1

# stamp PAGE NAME [COMMAND]: COMMAND (of bench/figures.txt); PROCESSOR; commit HASH; code PARTS DIGESTS. NAME is - for a table
stamp() {
    awk -F '|' -v page="$1" -v name="$2" -v command="$3" -v processor="$(processor)" -v commit="$(commit)" '
        $1 == page && $2 == name { found = 1
            printf "%s; %s; commit %s; code %s %s", command == "" ? $3 : command, processor, commit, $4, $5 }
        END { if (!found) { print page ": " name " is not in bench/figures.txt" | "cat 1>&2"; exit 1 } }' build/code.begun
}
# splice PAGE NAME FILE [COMMAND]: PAGE is README.md or lies in docs
splice() {
    page=docs/$1; [ "$1" = README.md ] && page=$1
    if grep -q '<!-- busy' "$3"; then echo "$page keeps its $2: other work ran on the machine; measure again when it is quiet"; return 1; fi
    grep -q "<!-- $2: begin -->" "$page" || { echo "$page has no place for $2"; exit 1; }
    stamp "$page" "$2" "$4" > build/page.stamp || exit 1
    awk -v begin="<!-- $2: begin -->" -v end="<!-- $2: end -->" -v name="$2" -v file="$3" '
        $0 == end { skip = 0 }
        !skip { print }
        $0 == begin { getline line < "build/page.stamp"; print "<!-- " name ": " line " -->"
            while ((getline line < file) > 0) print line; skip = 1 }' "$page" > build/page.new &&
    cp build/page.new "$page" && echo "$page: $2"
}
# numbers FILE...: tables of numbers, into docs/data; their first line has the command and the machine, and gets the rest
numbers() {
    mkdir -p docs/data
    for f in "$@"; do
        data=docs/data/$(basename "$f")
        stamp "$data" - > build/page.stamp || exit 1
        awk 'NR == 1 { getline line < "build/page.stamp"; sub(/.*; commit /, "; commit ", line); $0 = $0 line } { print }' "$f" > "$data" &&
            echo "$data"
    done
}
# picture SVG PNG FILE: converts it, and adds it to the file that is to be spliced
picture() {
    if command -v rsvg-convert >/dev/null 2>&1; then rsvg-convert "$1" -o "docs/images/$2" && printf '\n![](images/%s)\n' "$2" >> "$3"
    else echo "SKIP: rsvg-convert not found (Debian package librsvg2-bin): docs/images/$2 stays as it was"; fi
}
# the processor, with family and model: "AMD EPYC" is sold in every generation
processor() {
    awk -F '[\t ]*: ' '/^cpu family/ { f = $2 } /^model\t/ { m = $2 } /^model name/ { n = $2 }
        END { if (n == "") print "unknown processor"; else printf "%s (family %s, model %s)", n, f, m }' /proc/cpuinfo
}
commit() { git rev-parse --short HEAD 2>/dev/null || echo unknown; }
# data NAME COMMAND FILE: docs/data/NAME.csv is FILE, a table, below a line with its stamp
data() {
    mkdir -p docs/data
    stamp "docs/data/$1.csv" - "$2" > build/page.stamp || exit 1
    { echo "# $(cat build/page.stamp)"; cat "$3"; } > "docs/data/$1.csv" && echo "docs/data/$1.csv"
}
# measured COMMAND: the last line of a block
measured() { printf '\nMeasured by `%s`, dem.h at commit %s.\n' "$1" "$(commit)"; }
# a row a scene: rates of the three builds, from their summaries
rates() {
    cat build/out/bench/summary.txt build/out/bench_single/summary.txt build/out/bench_O2/summary.txt | awk '
        / = / && $1 ~ /^(bed|drum|gas)\.(double|single|double\.O2)\.rate$/ {
            split($1, part, "."); build = part[2] (part[3] == "O2" ? ".O2" : ""); rate[part[1], build] = 1e-6*$3 }
        END { print "| scene | double | single | speed, single over double | double, `-O2` without `-march=native` |"; print "|---|---|---|---|---|"
            n = split("bed drum gas", scene, " ")
            for (i = 1; i <= n; i++) { d = rate[scene[i], "double"]; s = rate[scene[i], "single"]; o = rate[scene[i], "double.O2"]
                printf "| %s | %.1f | %.1f | %.2f | %s |\n", scene[i], d, s, d ? s/d : 0, o ? sprintf("%.1f", o) : "" } }'
}
# a row per scene and code, from what bench/peers.sh prints on one core
peers() {
    awk '/ = / && / rounds\)$/ { split($0, p, / = | \(| to |, | rounds/); at[p[1]] = p[2] " | " p[3] " | " p[4] " | " p[5] }
        END { print "| scene | compared with | speed of dem.h over the other | smallest | largest | rounds |"; print "|---|---|---|---|---|---|"
            row("bed.double.vs_lammps", "bed, 20,000 spheres at rest", "LAMMPS"); row("bed.double.vs_liggghts", "the same", "LIGGGHTS")
            row("million.double.vs_lammps", "bed, 980,000 spheres", "LAMMPS")
            row("gas.double.vs_lammps", "gas, 32,768 spheres", "LAMMPS")
            row("drum.double.vs_liggghts", "drum with lifters, 18,000 spheres, mesh of 240 triangles", "LIGGGHTS")
            row("mesh.double.vs_liggghts", "the same drum, mesh of 61,440 triangles", "LIGGGHTS")
            row("mixture.double.vs_lammps", "mixture 1:10, 20,000 spheres of 0.5 mm and 200 of 5 mm", "LAMMPS, `gran/hertz/history`")
            row("mixture.double.vs_lammpslaw", "the same", "LAMMPS, the law of dem.h (`granular`)")
            n = split("clumps3 clumps clumps10 clumps30", name, " "); split("3 8 10 30", spheres, " ")
            for (i = 1; i <= n; i++) {
                row(name[i] ".double.vs_liggghts", "1000 clumps of " spheres[i] " spheres", "LIGGGHTS")
                row(name[i] ".unshared.vs_liggghts", "the same, `DEM_CLUSTER_CONTACTS_SEPARATE`", "LIGGGHTS") }
            row("servo_plane.double.vs_rest", "bed below a plane, its motion set at every step", "dem.h, plane at rest")
            row("servo_mesh.double.vs_rest", "bed below a mesh of 200 triangles, its motion set at every step", "dem.h, mesh at rest") }
        function row(key, about, other) { if (key in at) printf "| %s | %s | %s |\n", about, other, at[key] }' "$1"
}
# the same, in full: times and states
peers_details() {
    awk '/^# .* ns per step and body/ { split($2, p, ".")
            printf "%s| %s | %s | %s | %s | %s | %s | %s | %s |\n", rows++ ? "" : "| scene | code | ns per step and body, median | smallest | largest | contacts per body | mean overlap, µm | kinetic energy, J |\n|---|---|---|---|---|---|---|---|\n",
                p[1], p[2] == "double" ? "dem.h" : p[2] == "unshared" ? "dem.h, separate contacts" : p[2] == "rest" ? "dem.h, lid at rest" : p[2] == "single" ? "dem.h, single precision" : p[2] == "O2" ? "dem.h, `-O2`" : p[2] == "lammpslaw" ? "LAMMPS, law of dem.h" : toupper(p[2]),
                value("median"), value("smallest"), value("largest"), value("contacts/body"), value("overlap") + 0 ? value("overlap") : "", value("kinetic") }
        /^# (LAMMPS|LIGGGHTS|YADE) / { sub(/^# /, ""); sub(/, compiled.*/, ")"); versions = versions (versions == "" ? "" : ", ") $0 }
        END { printf "\nVersions: %s.\n", versions == "" ? "dem.h only" : versions }
        function value(key,   i, v) { for (i = 3; i < NF; i++) if ($i == key) { v = $(i + 1); sub(/[,;]$/, "", v); return v }; return "" }' "$1"
}
# a row per scene and code, with two cores; empty where a code or a second core was missing
peers_two() {
    awk '/ = / && / rounds\)$/ { split($0, p, / = | \(| to |, | rounds/); at[p[1]] = p[2] " (" p[3] " to " p[4] ")" }
        /^# load/ { print "<!-- busy -->" }
        END { print "| scene | compared with | one core | two cores | one core, dem.h in single precision |"; print "|---|---|---|---|---|"
            about["bed"] = "bed, 20,000 spheres at rest"; about["drum"] = "drum with lifters, 18,000 spheres"
            about["gas"] = "gas, 32,768 spheres"; name["lammps"] = "LAMMPS"; name["liggghts"] = "LIGGGHTS"
            n = split("bed.lammps bed.liggghts drum.liggghts gas.lammps", row, " ")
            for (i = 1; i <= n; i++) { split(row[i], p, ".")
                printf "| %s | %s | %s | %s | %s |\n", about[p[1]], name[p[2]], at[p[1] ".double.vs_" p[2]],
                    at[p[1] ".double.vs_" p[2] ".threads2"], at[p[1] ".single.vs_" p[2]] } }' "$1"
}
# a row per scene and code: beds of blocks
blocks() {
    awk '/^# .* ns per step and body/ { split($2, p, "."); time[p[1], p[2]] = 1e-3*value("median"); touch[p[1], p[2]] = value("contacts/body"); sank[p[1], p[2]] = value("sank") }
        / = / && / rounds\)$/ { split($0, p, / = | \(| to |, | rounds/); at[p[1]] = p[2] " | " p[3] " to " p[4] }
        END {
            print "| bed | code | time of a step and body, µs | contacts per body | centre of mass sank by, µm | time over that of dem.h | smallest to largest | time over that of dem.h with separate contacts | smallest to largest |"
            print "|---|---|---|---|---|---|---|---|---|"
            about["clumps"] = "clumps of 8 spheres"; about["cubes"] = "cubes"
            name["double"] = "dem.h"; name["unshared"] = "dem.h, `DEM_CLUSTER_CONTACTS_SEPARATE`"; name["liggghts"] = "LIGGGHTS, multispheres"
            name["yadeclumps"] = "YADE, clumps"; name["yadecubes"] = "YADE, polyhedra"
            n = split("clumps.double clumps.unshared clumps.liggghts clumps.yade cubes.double cubes.yade", row, " ")
            for (i = 1; i <= n; i++) { split(row[i], p, "."); s = p[1]; c = p[2]
                if (!((s, c) in time)) continue
                printf "| %s | %s | %.3g | %.2f | %s | %s | %s |\n", about[s], name[c == "yade" ? c s : c], time[s, c], touch[s, c], sank[s, c],
                    times(s ".double.vs_" c), times(s ".unshared.vs_" c) } }
        function times(key) { return key in at ? at[key] : " | " }
        function value(key,   i, v) { for (i = 3; i < NF; i++) if ($i == key) { v = $(i + 1); sub(/[,;]$/, "", v); return v }; return "" }' "$1"
}
# the cost of effects for the README: some rows of effects.csv, in words
prices() {
    awk -F, '/^#/ { next }
        { cost[$1] = $(NF - 3); spread[$1] = $(NF - 2) }
        END { print "| effect | time of a step [without it = 1] | spread [%] |"; print "|---|---|---|"
            n = split("friction tangent.mindlin_rescaled rolling.epsd rolling.constant ledger one_unlike two_species all_unlike orientation periodicity feed", row, " ")
            split("friction with a spring (Cundall-Strack)/rescaled Mindlin friction instead of that spring/rolling resistance (EPSD)/rolling resistance (constant torque)/energy ledger/one grain that differs from 20,000 equal ones/two sizes, half of the grains each/a different size for every grain/orientations of spheres/periodic box/feed (one bead every fourth step)", word, "/")
            for (i = 1; i <= n; i++) if (row[i] in cost) {
                more = 100*(cost[row[i]] - 1); if (more < 0) more = -more
                if (more > spread[row[i]]) printf "| %s | %s | %s |\n", word[i], cost[row[i]], spread[row[i]]
                else hidden = hidden (hidden == "" ? "" : "; ") word[i]
            }
            if (hidden != "") printf "\nThese differ from 1 by less than their spread: %s.\n", hidden }' "$1"
}
# times of the glass screener beside the thesis's, for two stiffnesses, from their summaries
screener_times() {
    cat "$1" "$2" | awk '
        /^N[0-9]+\./ { split(substr($1, 2), p, "."); n = p[1]; what = p[2]
            if (what == "compute" || what == "overlap" || what == "left") { seen[n, what]++; value[n, what, seen[n, what]] = $3 }
            if (what == "thesis_compute") thesis[n] = $3 }
        END { print "| balls | machine time (s) | thesis (h) | 200 N/m: time (s) | ratio | overlap (radii) | 2000 N/m: time (s) | ratio | overlap (radii) |"; print "|---|---|---|---|---|---|---|---|---|"
            k = split("775 4950 9900", row, " "); split("20 25 45", time, " ")
            for (i = 1; i <= k; i++) { n = row[i]
                printf "| %d | %d | %.1f | %s | %s |\n", n, time[i], thesis[n]/3600, cells(n, 1), cells(n, 2) } }
        function cells(n, k,    t) { t = value[n, "compute", k]
            return t ? sprintf("%.0f | %.0f | %.3f", t, thesis[n]/t, value[n, "overlap", k]) : " | | " }'
}

# a row a size: millions of bodies times steps a second, beside the card of [RUB15]
gas_speeds() {
    printf '%s, dem.h at commit %s. Rates are in million body-steps per second.\n\n' "$(processor)" "$(commit)"
    awk -F , 'NR == 1 { print "| bodies | ellipsoids, one core | ellipsoids, GPU of [RUB15] | ratio | spheres, one core | spheres, GPU of [RUB15] | ratio |"; print "|---|---|---|---|---|---|---|"; next }
        { printf "| %d | %.1f | %.2g | %.1f | %.0f | %.2g | %.0f |\n", $1, 1e-6*$2, 1e-6*$3, $2/$3, 1e-6*$4, 1e-6*$5, $4/$5 }' "$1"
}

at=build/out
for what in "$@"; do
    case $what in
    effects)
        build/bench --scene effects --threads 1 && splice accuracy.md effects $at/bench/page.md || exit 1
        numbers $at/bench/effects.csv
        prices $at/bench/effects.csv > build/prices.md && splice README.md prices build/prices.md || exit 1 ;;
    accuracy)
        build/accuracy_single && build/accuracy_one_domain && build/accuracy || exit 1
        splice accuracy.md accuracy $at/accuracy/page.md || exit 1
        numbers $at/accuracy/accuracy_efficient.csv $at/accuracy/accuracy_numbers.csv $at/accuracy/accuracy_softening.csv
        if command -v rsvg-convert >/dev/null 2>&1; then         # the page links them itself
            for s in $at/accuracy/*.svg; do rsvg-convert -w 760 "$s" -o "docs/images/accuracy_$(basename "$s" .svg).png"; done
        else echo "SKIP: rsvg-convert not found (Debian package librsvg2-bin): pictures stay as they were"; fi
        build/bench --brief && build/bench_single --brief && build/bench_O2 --brief || exit 1
        rates > build/rates.md && splice accuracy.md precision build/rates.md ;;
    roofline)
        build/roofline || exit 1
        splice roofline.md roofline_counts $at/roofline/counts.md || exit 1
        numbers $at/roofline/roofline_counts.csv
        for s in bed drum gas; do picture $at/roofline/roofline_$s.svg roofline_$s.png $at/roofline/page.md; done
        splice roofline.md roofline $at/roofline/page.md ;;
    instructions)
        rm -f $at/instructions/page.md
        sh bench/instructions.sh || exit 1
        if [ -f $at/instructions/page.md ]; then splice roofline.md instructions $at/instructions/page.md || exit 1; fi ;;
    clusters)
        rm -f $at/parallel/*.svg
        build/parallel --threads ${THREADS:-8} && build/parallel --model || exit 1
        for s in speedup speedup_shapes speedup_tables scaling searches; do
            [ -f $at/parallel/$s.svg ] && picture $at/parallel/$s.svg parallel_$s.png $at/parallel/page.md
        done
        measured "make bench-pages PAGES=clusters" >> $at/parallel/page.md
        measured "make bench-pages PAGES=clusters" >> $at/model/page.md
        picture $at/model/model.svg clusters_model.png $at/model/page.md
        splice clusters.md measured $at/parallel/page.md || exit 1
        for s in speedups messages; do data clusters_$s "make bench-pages PAGES=clusters" $at/parallel/$s.csv; done
        splice clusters.md model $at/model/page.md || exit 1
        data clusters_model "make bench-pages PAGES=clusters" $at/model/model.csv ;;
    shapes)
        build/shapes || exit 1
        measured "make bench-pages PAGES=shapes" >> $at/shapes/page.md
        splice shapes.md shapes $at/shapes/page.md || exit 1
        for s in ellipsoids rotation bed; do data shapes_$s "make bench-pages PAGES=shapes" $at/shapes/$s.csv; done ;;
    screener)
        for k in 200 2000; do build/screener --study size --stiffness $k --out $at/screener_size$k || exit 1; done
        screener_times $at/screener_size200/summary.txt $at/screener_size2000/summary.txt > build/page.times
        splice screener.md screener build/page.times ;;
    ellipsoids)
        build/ellipsoids --theory || exit 1
        data ellipsoids_theory "build/ellipsoids --theory; dimensionless, S_c in units of the square of the semi-axis b" $at/ellipsoids/theory.csv
        build/ellipsoids --speeds --threads 1 || exit 1
        gas_speeds $at/ellipsoids/speeds.csv > build/page.speeds
        splice ellipsoids.md speeds build/page.speeds ;;
    lessons)
        # JOBS lessons at a time, each on one thread: the figures do not depend on the number of threads
        ls examples/[0-9][0-9]_*.c | sed 's/.*\///; s/\.c$//' > build/lessons.txt
        (unset OMP_PROC_BIND OMP_PLACES
        OMP_NUM_THREADS=1 xargs -P "${JOBS:-1}" -n 1 sh -c 'mkdir -p build/out/$1 && cd build/out/$1 &&
            { ../../$1 > log 2>&1 || { echo "build/$1 ends with code $?:"; tail -n 5 log; exit 1; }; }' run < build/lessons.txt) || exit 1
        awk -f bench/lessons.awk $(sed 's/.*/build\/out\/&\/log/' build/lessons.txt) > build/page.lessons || exit 1
        splice teaching.md lessons build/page.lessons || exit 1 ;;
    heap)
        mkdir -p $at/readme && (cd $at/readme && ../../readme_program > log 2>&1) || { cat $at/readme/log; exit 1; }
        { echo '```'; grep '^slope' $at/readme/log; echo '```'; } > build/page.heap && splice README.md heap build/page.heap || exit 1 ;;
    peers)
        # processor times: other programs may run at the same time
        LONG=1 SCENES="bed million gas drum mesh mixture clumps3 clumps clumps10 clumps30 servo_plane servo_mesh" CORES=1 sh bench/peers.sh \
            > build/peers.out 2>&1 || { cat build/peers.out; exit 1; }
        cat build/peers.out
        grep -q 'vs_l.* = ' build/peers.out || { echo "neither LAMMPS nor LIGGGHTS was found: the pages stay as they were"; exit 1; }
        command="${ROUNDS:+ROUNDS=$ROUNDS }make bench-pages PAGES=peers"
        peers build/peers.out > build/peers.md && splice README.md peers build/peers.md "$command" || exit 1
        peers_details build/peers.out > build/peers.md && splice peers.md peers_details build/peers.md "$command" || exit 1 ;;
    peers_two)
        CLOCK=wall CORES="1 2" SCENES="bed drum gas" sh bench/peers.sh > build/peers_two.out 2>&1 || { cat build/peers_two.out; exit 1; }
        cat build/peers_two.out
        grep -q 'vs_l.* = ' build/peers_two.out || { echo "neither LAMMPS nor LIGGGHTS was found: peers.md stays as it was"; exit 1; }
        peers_two build/peers_two.out > build/peers.md &&
            splice peers.md peers_two build/peers.md "${ROUNDS:+ROUNDS=$ROUNDS }make bench-pages PAGES=peers_two" || exit 1 ;;
    blocks)
        SCENES="clumps cubes" CORES=1 sh bench/peers.sh > build/blocks.out 2>&1 || { cat build/blocks.out; exit 1; }
        cat build/blocks.out
        grep -q ' = ' build/blocks.out || { echo "neither code was found: shapes.md stays as it was"; exit 1; }
        { blocks build/blocks.out; measured "ROUNDS=${ROUNDS:-5} make bench-pages PAGES=blocks"; } > build/blocks.md
        splice shapes.md blocks build/blocks.md "${ROUNDS:+ROUNDS=$ROUNDS }make bench-pages PAGES=blocks" || exit 1 ;;
    *) echo "no page $what: effects, accuracy, roofline, instructions, clusters, shapes, screener, ellipsoids, peers, peers_two, blocks, lessons, heap or files"; exit 1 ;;
    esac
done
