# sh tests/verdicts.sh DEM.o: laws as students write them and those of the pages, and the verdict of the exam
# (examples/exam.c) on each.
# The last line is "N passed, N failed".
object=$1; dir=build/out/verdicts; passed=0; failed=0
mkdir -p $dir
# verdict NAME "BODY" "FIELDS OF LAW" "LINES": BODY is that of the function; LINES are the beginnings of the lines that must
# be found, in order, separated by commas; "" for none; "compile: TEXT" if the compiler must say TEXT
verdict() {
    { echo '#include <stdlib.h>'
      echo "static void law(const dem_contact *c, dem_real *memory, dem_contact_force *f) { (void)c; (void)memory; $2 }"
      [ -z "$3" ] || echo "#define LAW {\"$1\", law, $3}"; } > $dir/$1.h
    examine "$1" "$4"
}
# page_law PAGE FUNCTION "BEFORE" "FIELDS OF LAW" "LINES": the block of a page with this function; BEFORE stands above it; no
# fields: the block has its row LAW
page_law() {
    name=$(basename "$1" .md)_$2
    { echo "$3"; awk -v name="$2(const dem_contact" '/^```/ { if (c && index(text, name)) printf "%s", text; c = !c; text = ""; next }
        c && !/include "dem.h"/ { text = text $0 "\n" }' "$1"
      [ -z "$4" ] || echo "#define LAW {\"$name\", $2, $4}"; } > $dir/$name.h
    examine "$name" "$5"
}
examine() {                                    # NAME LINES
    name=$1
    if ! ${CC:-cc} ${CFLAGS:--O1} -w -I. -DLAW_FILE="\"$PWD/$dir/$name.h\"" examples/exam.c "$object" -o $dir/$name ${LINK:--lm} 2> $dir/$name.log; then
        found=compile; case $2 in "compile: "*) grep -q "${2#compile: }" $dir/$name.log && found=$2;; esac; code=1
    else
        $dir/$name --out $dir > $dir/$name.txt 2> $dir/$name.log; code=$?
        found=$(sed -n 's/^FOUND   \(.*[^ ]\)   *.*/\1/p' $dir/$name.txt | cut -c1-38 | sed 's/ *$//' | grep -v '^quick' | paste -sd, -)
    fi
    wanted=1; [ -n "$2" ] || wanted=0
    if [ "$found" = "$2" ] && [ $code = $wanted ]; then passed=$((passed + 1)); echo "ok     $name"
    else failed=$((failed + 1)); echo "FAILED $name: found \"$found\" with code $code, wanted \"$2\" with $wanted"; fi
}
spring='f->normal = 1e4*c->overlap + 0.02*c->closing_speed;'
shear='dem_vec3 s = dem_memory_rotate(c, dem_vec3_make(memory[0], memory[1], memory[2])); dem_real size, most = 0.4*f->normal;
    s.x += c->slip_step.x*c->dt; s.y += c->slip_step.y*c->dt; s.z += c->slip_step.z*c->dt;
    size = 3e3*sqrt(s.x*s.x + s.y*s.y + s.z*s.z); if (most < 0) most = 0;
    if (size > most) { s.x *= most/size; s.y *= most/size; s.z *= most/size; }
    f->tangent = dem_vec3_make(-3e3*s.x, -3e3*s.y, -3e3*s.z);
    if (c->dt > 0) { memory[0] = s.x; memory[1] = s.y; memory[2] = s.z; }'
verdict spring_dashpot "$spring" "0, 0, 0, 1e4" ""
verdict with_friction "$spring $shear" "0, 3, 1, 1e4" ""
verdict not_rotated "$spring $(echo "$shear" | sed 's/dem_memory_rotate(c, \(.*\)); dem_real/\1; dem_real/')" "0, 3, 1, 1e4" "rotates with the contact"
verdict by_slip "$spring $(echo "$shear" | sed 's/slip_step/slip/g')" "0, 3, 1, 1e4" "springs grow by slip_step"
verdict no_limit "$spring $(echo "$shear" | sed 's/most = 0.4.*normal;/most = 1e30;/')" "0, 3, 1, 1e4" "friction has a limit"
verdict sign "f->normal = 1e4*c->overlap - 0.02*c->closing_speed;" "0, 0, 0, 1e4" \
    "no energy from pressing,no energy from pressing while sheared,no energy from impacts,stable at the largest allowed step"
verdict overdamped "f->normal = 1e4*c->overlap + 2*c->closing_speed;" "0, 0, 0, 1e4" "stable at the largest allowed step"
verdict beyond_memory "$spring memory[3] += c->dt;" "0, 0, 0, 1e4" "memory only in a step"
verdict ends_program "$spring exit(0);" "0, 0, 0, 1e4" "finite, whatever comes"
verdict crashes "$spring f->normal += *(dem_real *)(size_t)(c->overlap > 0);" "0, 0, 0, 1e4" "finite, whatever comes"
verdict endless "while (c->overlap > 0) f->normal = 0;" "0, 0, 0, 1e4" "finite, whatever comes"
verdict without_LAW "$spring" "" "compile: has no line"
verdict unfinished "f->normal = 1e4*c->overlap" "0, 0, 0, 1e4" "compile: expected"
# laws of the pages: each passes, but for the first try of own_law.md, whose page tells the line that it fails
page_law README.md sticky "" "" ""
page_law docs/laws.md my_law "" "" ""
page_law docs/laws.md warm_law "static struct { dem_real conductance, capacity; } mine = {1, 800};" "&mine, 4, 1, 0, DEM_NORMAL_HERTZ, -1, 0, 1" ""
page_law docs/laws.md wet_or_dry "static struct { dem_real tension, angle, volume; } mine = {0.073, 0.3, 4e-12};" "&mine, 5, 1, 0, DEM_NORMAL_HERTZ, -1, 2e-4" ""
page_law docs/own_law.md skin_law "" "" "no energy from pressing while sheared"
page_law docs/own_law.md rough_law "" "" ""
page_law docs/extending.md spring_law "" "0, 3, 1, 1e4" ""
page_law docs/extending.md sticky_law "" "0, 4, 1" ""
page_law docs/how_to_more.md sticky "static double mine = 1e-3;" "&mine, 4, 1" ""
page_law docs/how_to_more.md conduct "" "0, 4, 1, 0, DEM_NORMAL_HERTZ, -1, 0, 1" ""
# make marks: the same laws as the work of a class, and answers to exercises
class=$dir/class; rm -rf $class; mkdir -p $class
for student in $(sed -n 's/^verdict \([a-zA-Z_]*\) .*/\1/p' "$0"); do cp $dir/$student.h $class; done
[ ! -x build/01_bounce ] || printf '# NAME LESSON EXERCISE VALUE\nAda 01_bounce 1 0.0565\nBob 01_bounce 1 3\nEve 01_bounce 3 1\nEve rm 1 1\n' > $class/answers.txt
CC=${CC:-cc} LINK="$LINK" sh examples/marks.sh $class "$object" > $dir/marks.txt 2>&1
cut -d, -f 1-5 $class/marks.csv > $dir/marks.csv
{ cat <<END
student,task,result,points,of
beyond_memory,law,found,15,16
by_slip,law,found,15,16
crashes,law,stopped,0,16
endless,law,stopped,0,16
ends_program,law,stopped,0,16
no_limit,law,found,15,16
not_rotated,law,found,15,16
overdamped,law,found,15,16
sign,law,found,12,16
spring_dashpot,law,passed,16,16
unfinished,law,does not compile,0,16
with_friction,law,passed,16,16
without_LAW,law,does not compile,0,16
END
[ ! -f $class/answers.txt ] || cat <<END
Ada,01_bounce 1,right,1,1
Bob,01_bounce 1,wrong,0,1
Eve,01_bounce 3,not understood,0,1
Eve,rm 1,not understood,0,1
END
} > $dir/marks.right
if cmp -s $dir/marks.right $dir/marks.csv; then passed=$((passed + 1)); echo "ok     marks of a class"
else failed=$((failed + 1)); echo "FAILED marks of a class:"; diff $dir/marks.right $dir/marks.csv; fi
# SEEDS=1: each name has its own numbers, so the answer of Ada is right for Ada and wrong for Bob
seeds=$dir/seeds; rm -rf $seeds; mkdir -p $seeds
if [ -x build/01_bounce ]; then
    answer=$(build/01_bounce --seed Ada | awk '/^1  / { for (i = 1; i < NF; i++) { if ($i == "=") e = $(i + 1); if ($(i + 1) == "m.") h = $i }
        printf "%.6g", h*e^10 }')
    printf 'Ada 01_bounce 1 %s\nada 01_bounce 1 %s\nBob 01_bounce 1 %s\n- 01_bounce 1 1\n' "$answer" "$answer" "$answer" > $seeds/answers.txt
    SEEDS=1 sh examples/marks.sh $seeds "$object" > $dir/seeds.txt 2>&1
    cut -d, -f 1-5 $seeds/marks.csv > $dir/seeds.csv
    printf '%s\n' student,task,result,points,of 'Ada,01_bounce 1,right,1,1' 'ada,01_bounce 1,right,1,1' 'Bob,01_bounce 1,wrong,0,1' \
        '-,01_bounce 1,not understood,0,1' > $dir/seeds.right
    if cmp -s $dir/seeds.right $dir/seeds.csv; then passed=$((passed + 1)); echo "ok     marks with numbers for each name"
    else failed=$((failed + 1)); echo "FAILED marks with numbers for each name:"; diff $dir/seeds.right $dir/seeds.csv; fi
fi
echo "$passed passed, $failed failed"
[ $failed = 0 ]
