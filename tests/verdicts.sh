# sh tests/verdicts.sh DEM.o: laws as students write them, and the verdict of the exam (examples/exam.c) on each.
# The last line is "N passed, N failed".
object=$1; dir=build/out/verdicts; passed=0; failed=0
mkdir -p $dir
# verdict NAME "BODY" "FIELDS OF LAW" "LINES": BODY is that of the function; LINES are the beginnings of the lines that must
# be found, in order, separated by commas; "" for none; "compile: TEXT" if the compiler must say TEXT
verdict() {
    name=$1
    { echo '#include <stdlib.h>'
      echo "static void law(const dem_contact *c, dem_real *memory, dem_contact_force *f) { (void)c; (void)memory; $2 }"
      [ -z "$3" ] || echo "#define LAW {\"$name\", law, $3}"; } > $dir/$name.h
    if ! ${CC:-cc} ${CFLAGS:--O1} -w -I. -DLAW_FILE="\"$PWD/$dir/$name.h\"" examples/exam.c "$object" -o $dir/$name ${LINK:--lm} 2> $dir/$name.log; then
        found=compile; case $4 in "compile: "*) grep -q "${4#compile: }" $dir/$name.log && found=$4;; esac; code=1
    else
        $dir/$name --out $dir > $dir/$name.txt 2> $dir/$name.log; code=$?
        found=$(sed -n 's/^FOUND   \(.*[^ ]\)   *.*/\1/p' $dir/$name.txt | cut -c1-38 | sed 's/ *$//' | grep -v '^quick' | paste -sd, -)
    fi
    wanted=1; [ -n "$4" ] || wanted=0
    if [ "$found" = "$4" ] && [ $code = $wanted ]; then passed=$((passed + 1)); echo "ok     $name"
    else failed=$((failed + 1)); echo "FAILED $name: found \"$found\" with code $code, wanted \"$4\" with $wanted"; fi
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
echo "$passed passed, $failed failed"
[ $failed = 0 ]
