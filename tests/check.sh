# sh tests/check.sh [short]: dem.h through every compiler, standard, precision and warning found here.
# The matrix is the middle of this file, one line a case. `short` leaves out most strict warnings, the
# optimisation levels and the test runs. A compiler that is missing is skipped, loudly. Ends with
# "N passed, N failed, N skipped" and a non-zero code when anything failed. A check that was interrupted, or in which
# a case failed, goes on: what passed with the same files and compilers is not run again, FRESH=1 runs all. CASES=REGEX
# runs the cases whose names match, NOT=REGEX leaves those out that match.
JOBS=${JOBS:-1}
export OMP_WAIT_POLICY=passive   # several programs share the cores: a thread that waits sleeps
dir=build/check; [ "$1" = short ] && dir=build/check_short
inputs=$({ find .ci Makefile *.md LICENSE bench dem.c dem.h docs examples src tests -type f | LC_ALL=C sort | xargs cat
    for cc in gcc clang tcc; do $cc -v 2>&1; done; } | cksum)
[ -z "$FRESH" ] && [ "$(cat $dir/inputs 2>/dev/null)" = "$inputs" ] || rm -rf $dir
mkdir -p $dir build/tmp; echo "$inputs" > $dir/inputs; rm -f $dir/*.sh
number=1000; skipped=0; left=0; turn=2                 # turn 1: the long ones, which begin first

found() { command -v "$1" >/dev/null 2>&1; }
skip() { echo "SKIP: $1"; skipped=$((skipped + 1)); }
# try NAME COMMAND...: one case. All run together below, JOBS at a time; $bin is the case's own program.
try() {
    number=$((number + 1)); name=$1; shift
    printf '# %s\nbin=%s/%s.bin\n%s\n' "$name" $dir $turn$number "$*" > $dir/$turn$number.sh
}

try "a lesson has less than 120 lines, of at most 120 columns" "awk 'length > 120 || FNR > 119 { print FILENAME \": \" FNR; bad = 1 } END { exit bad }' examples/[0-9][0-9]_*.c"
try "parts of dem.h in order" "awk -f tests/tags.awk dem.h"
try "no sentence of pages, public comments, error messages and test names needs a second reading" "make -s english"
try "dem.h calls no function of libm that libraries round in their own way" "awk -f tests/libm.awk dem.h"
try "tests/refused.h has a call of every public function of dem.h" "awk -f tests/refused.awk dem.h | cmp - tests/refused.h"
try "dem.h is joined from src/" "awk -f src/join.awk src/dem.h | cmp - dem.h"
try "dem.h split into src/ and joined is dem.h" "mkdir -p \$bin && cp -r src \$bin && awk -v to=\$bin/src -f src/split.awk src/dem.h dem.h && diff -r src \$bin/src"
try "docs/options.md and docs/options_run.md are those of dem.h" "cc -I. -DDEM_STATIC -DDEM_NO_OPENMP tests/options.c -o \$bin -lm && \$bin > \$bin.txt && for part in '' _run; do awk -v part=\${part#_} -f tests/options.awk - dem.h < \$bin.txt | cmp - docs/options\$part.md || exit 1; done"
try "the viewer in dem.h is examples/replay/viewer.html" "awk -f tests/viewer.awk examples/replay/viewer.html dem.h | cmp - dem.h"
[ "$1" = short ] || try "the exam of laws gives each law of a class its verdict" "make -s verdicts"
try "examples/upgrade.sh: tables, programs of users" "sh tests/upgrade.sh $([ "$1" = short ] || echo long)"
try "docs/find.md: functions that exist, with their arguments" "sh tests/find.sh"
try "the pages in examples/web/pages are those of their sources" "sh tests/web.sh"
if [ "$1" = short ]; then                     # the long form runs them all
    make -s build/rooms/private.h
    for cc in "g++ -std=c++11 -x c++" "clang -std=c99"; do
        found ${cc%% *} || continue
        try "${cc%% -*}: every test compiles" "for file in tests/[a-z]*/*.c; do $cc -w -I. -include build/rooms/private.h -fsyntax-only \$file || exit 1; done"
    done
fi

# what is compiled: the header alone, the implementation, both in one file, two files linked; the headers
# that stand beside dem.h and use its public part only
user=tests/two_files.c
try "the browser lesson as a program" "cc -std=c99 -Wall -Wextra -Werror -I. -DDEM_IMPLEMENTATION examples/web/lesson.c -o \$bin -lm && \$bin pile 300 && \$bin hopper 300 && \$bin drum 300"
companions=$dir/companions.c
printf '#include "dem.h"\n' > $companions
printf '#include "examples/%s.h"\n' corona drum lesson moldyn separator sorting tumbler >> $companions
printf '#include "%s"\n' examples/laws/*.h >> $companions
try "companions use public names only" "! grep -n 'demi_\|DEMI_' examples/corona.h examples/drum.h examples/moldyn.h examples/separator.h examples/sifting.h examples/sorting.h examples/tumbler.h examples/laws/*.h"
one_file="-DDEM_IMPLEMENTATION $user"
strict="-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wdouble-promotion -Wundef -Werror"
float="-DDEM_REAL=float"

# each switch alone, and all of them; `make check` also runs the tests that each can
for switch in NO_FILES NO_REPLAY NO_REPORTS NO_TRIALS NO_SLABS NO_IMPULSES NO_POLYHEDRA CORE; do
    for cc in "gcc -std=c99" "clang -std=c99" "g++ -std=c++11 -x c++"; do
        found ${cc%% *} || continue
        [ "$1" = short ] && [ $switch != CORE ] && [ "$cc" != "gcc -std=c99" ] && continue
        try "DEM_$switch, ${cc%% *}: strict" "$cc -I. $strict -DDEM_$switch -fsyntax-only dem.c"
    done
done
[ "$1" = short ] || { turn=1; try "tests with switches" "sh tests/switches.sh"; turn=2; }

# dem.h after other headers, whose macros must not be names in it: all of C99, those of POSIX, and two that are
# full of macros. capitals: every capital letter is a macro of the program
after() {                                      # GROUP HEADER...: those that are here, then dem.h
    group=$1; shift; : > $dir/after.h
    for header in "$@"; do
        printf '#include <%s>\n' "$header" > $dir/probe.c
        if cc -std=gnu99 -fsyntax-only $dir/probe.c 2>/dev/null; then cat $dir/probe.c >> $dir/after.h
        else skip "<$header> not found: dem.h is not compiled after it${hint:+ ($hint)}"; fi
    done
    [ -s $dir/after.h ] || return 0
    { cat $dir/after.h; printf '#define DEM_IMPLEMENTATION\n#include "dem.h"\n'; } > $dir/after_$group.c
    headers="$headers $group"
}
headers=all_capitals; hint=
{ for letter in A B C D E F G H I J K L M N O P Q R S T U V W X Y Z; do echo "#define $letter -;"; done
  printf '#define DEM_IMPLEMENTATION\n#include "dem.h"\n'; } > $dir/after_all_capitals.c
after standard_C99 assert.h complex.h ctype.h errno.h fenv.h float.h inttypes.h iso646.h limits.h locale.h math.h setjmp.h \
    signal.h stdarg.h stdbool.h stddef.h stdint.h stdio.h stdlib.h string.h time.h wchar.h wctype.h
after standard_tgmath tgmath.h
after system_POSIX dirent.h fcntl.h glob.h grp.h netdb.h netinet/in.h poll.h pthread.h pwd.h regex.h sched.h semaphore.h \
    sys/ipc.h sys/mman.h sys/param.h sys/resource.h sys/select.h sys/socket.h sys/stat.h sys/sysmacros.h sys/time.h \
    sys/types.h sys/un.h sys/wait.h syslog.h termios.h unistd.h utime.h
hint="Debian package libncurses-dev"; after system_curses curses.h
hint="Debian package libx11-dev"; after system_X11 X11/Xlib.h X11/Xutil.h
hint=

for cc in gcc clang tcc; do
    found $cc || { skip "$cc not found (Debian package $cc)"; continue; }
    openmp=; hint=; [ $cc = clang ] && hint=" (Debian package libomp-dev)"
    echo 'int main(void) { return omp_get_max_threads() < 1; }' > $dir/probe.c
    if $cc -include omp.h $dir/probe.c -o $dir/probe -fopenmp 2>/dev/null; then openmp=-fopenmp
    else skip "$cc has no OpenMP$hint"; fi
    # tcc evaluates closing + couple*dot(a, b) of floats wrongly: dem.h refuses to run
    [ $cc = tcc ] && try "tcc float: a world is refused" "tcc -I. $float $one_file -o \$bin -lm && { \$bin; test \$? -eq 1; }"
    for real in "" $float; do
        [ $cc = tcc ] && [ "$real" ] && continue
        try "$cc${real:+ float}: one file"                 "$cc -I. $real $one_file -o \$bin -lm && \$bin"
        # the short form leaves the other combinations of single precision and of clang to the long one
        [ "$1" = short ] && [ "$real$cc" != gcc ] && [ "$real$cc" != tcc ] && continue
        try "$cc${real:+ float}: two files linked"         "$cc -I. $real -c dem.c -o \$bin.o && $cc -I. $real $user \$bin.o -o \$bin -lm && \$bin"
        try "$cc${real:+ float}: after windows.h's near and far" \
            "$cc -I. $real '-Dnear=' '-Dfar=' $one_file -o \$bin -lm && \$bin"
        try "$cc${real:+ float}: DEM_STATIC"               "$cc -I. $real -DDEM_STATIC $one_file -o \$bin -lm && \$bin"
        try "$cc${real:+ float}: DEM_NO_SPECIALIZE"        "$cc -I. $real -DDEM_NO_SPECIALIZE $one_file -o \$bin -lm && \$bin"
        [ "$openmp" ] &&
        try "$cc${real:+ float}: OpenMP"                   "$cc -I. $real -O1 -fopenmp $one_file -o \$bin -lm && \$bin"
    done
    parse=-fsyntax-only; [ $cc = tcc ] && parse=
    for group in $headers; do
        [ "$1" = short ] && [ $cc = clang ] && continue      # names are the same for both
        [ $cc = tcc ] && [ $group != all_capitals ] ||      # tcc does not read all that the C library has
        try "$cc: after ${group%%_*} headers, ${group#*_}" "$cc -std=gnu99 -I. $parse -c $dir/after_$group.c -o \$bin.o"
    done
    try "$cc: header and implementation of two precisions refuse each other" \
        "$cc -I. -c dem.c -o \$bin.o && $cc -I. $float $user \$bin.o -o \$bin -lm && { \$bin; test \$? -eq 1; }"
    [ $cc = tcc ] && continue
    for source in bench/*.c; do                 # they call functions that are not public
        try "$cc: strict, $source"                  "$cc -std=c99 -I. $strict $openmp -fsyntax-only $source"
    done
    [ "$1" = short ] && continue

    for std in c99 c11; do for real in "" $float; do
        try "$cc -std=$std${real:+ float}: strict, header alone"   "$cc -std=$std -I. $real $strict -c $user -o \$bin.o"
        try "$cc -std=$std${real:+ float}: strict, implementation" "$cc -std=$std -I. $real $strict -O1 -c dem.c -o \$bin.o"
    done; done
    for real in "" $float; do
        try "$cc${real:+ float}: strict, OpenMP"            "$cc -std=c99 -I. $real $strict $openmp -c dem.c -o \$bin.o"
        try "$cc${real:+ float}: strict, DEM_NO_OPENMP"     "$cc -std=c99 -I. $real $strict $openmp -DDEM_NO_OPENMP -c dem.c -o \$bin.o"
        try "$cc${real:+ float}: strict, DEM_STATIC"        "$cc -std=c99 -I. $real $strict -DDEM_STATIC -c dem.c -o \$bin.o"
        try "$cc${real:+ float}: strict, DEM_NO_SPECIALIZE" "$cc -std=c99 -I. $real $strict -DDEM_NO_SPECIALIZE -c dem.c -o \$bin.o"
        try "$cc${real:+ float}: strict, DEM_NO_CLONES"     "$cc -std=c99 -I. $real $strict -DDEM_NO_CLONES -O1 -c dem.c -o \$bin.o"
    done
    for real in "" $float; do
        try "$cc${real:+ float}: strict, companions"        "$cc -std=c99 -I. $real $strict -O1 -c $companions -o \$bin.o"
    done
    for source in examples/[0-9][0-9]_*.c; do
        try "$cc: strict, $source"                  "$cc -std=c99 $strict -fsyntax-only $source"
    done
    for level in -O0 -O1 -O2 -O3 "-O3 -ffast-math"; do
        try "$cc $level: run"                      "$cc -std=c99 -I. $level $one_file -o \$bin -lm && \$bin"
    done
done

for cxx in g++ clang++; do
    package=${cxx%++}; [ $cxx = g++ ] && package=g++
    found $cxx || { skip "$cxx not found (Debian package $package)"; continue; }
    for std in c++11 c++17; do
        [ "$1" = short ] && [ $std = c++17 ] && continue
        try "$cxx -std=$std: one file"             "$cxx -std=$std -I. -x c++ $one_file -o \$bin -lm && \$bin"
        [ "$1" = short ] && level=-fsyntax-only || level=-O1
        for real in "" $float; do
            try "$cxx -std=$std${real:+ float}: strict"     "$cxx -std=$std -I. $real $strict $level -x c++ -c dem.c -o \$bin.o"
        done
        [ "$1" = short ] && continue
        for source in examples/[0-9][0-9]_*.c; do
            try "$cxx -std=$std: strict, $source"           "$cxx -std=$std $strict -fsyntax-only -x c++ $source"
        done
        try "$cxx -std=$std: strict, DEM_STATIC"   "$cxx -std=$std -I. $strict -DDEM_STATIC -x c++ -c dem.c -o \$bin.o"
        for real in "" $float; do
            try "$cxx -std=$std${real:+ float}: strict, companions" "$cxx -std=$std -I. $real $strict -O1 -x c++ -c $companions -o \$bin.o"
        done
    done
    found gcc &&
    try "$cxx user, gcc implementation"            "gcc -I. -c dem.c -o \$bin.o && $cxx -I. -x c++ $user -x none \$bin.o -o \$bin -lm && \$bin"
done

printf '#include <errno.h>\nint main(void) { return errno; }\n' > $dir/probe.c     # its headers are another package's
run32=none                                     # how 32-bit programs are run: empty, by themselves
if found gcc && gcc -m32 $dir/probe.c -o $dir/probe 2>/dev/null; then
    if $dir/probe 2>/dev/null; then run32=
    elif found qemu-i386; then run32=qemu-i386
    else skip "gcc -m32 only compiles: this kernel runs no 32-bit programs, and qemu-i386 not found (Debian package qemu-user)"; fi
    for real in "" $float; do
        [ "$run32" = none ] ||
        try "gcc -m32${real:+ float}: run"                  "gcc -m32 -msse2 -mfpmath=sse -I. $real $one_file -o \$bin -lm && $run32 \$bin"
        [ "$1" = short ] ||
        try "gcc -m32${real:+ float}: strict"               "gcc -std=c99 -m32 -msse2 -mfpmath=sse -I. $real $strict -O1 -c dem.c -o \$bin.o"
    done
else skip "gcc -m32 does not link (Debian package gcc-multilib)"; fi

# tests NAME CC CFLAGS LDFLAGS: all tests, built and run in a folder of the case's own. tcc does not optimise, so its
# programs are ten times as slow: it leaves the hard cases and these tests out, which would take hours. Where an emulator
# runs the programs, only three.
emulator=
long="api|body_reals|bonds|cell|cells|corona|decompose|exam|facets|flats|flush|growth|joints|kept|members|memory|more_laws|"
long="$long""polygons|polyhedra|rocks|rotation|search|servo|shapes|sieve_rocks|slabs|solvers|surfaces|tessellate|trials|tumbler"
tests() {
    turn=1
    names=$(for t in tests/*/test_*.c tests/hard/hard_*.c; do echo "build/$(basename "$t" .c)"; done)
    [ "$2" = tcc ] && names=$(echo "$names" | grep -vE "/hard_|/test_($long)\$")
    [ "$emulator" ] && names="build/test_api build/test_feed build/test_own_law"
    try "$1: tests" "mkdir -p \$bin && for f in Makefile bench dem.c dem.h docs examples src tests; do ln -sfn \$PWD/\$f \$bin/\$f; done &&" \
        "cd \$bin && mkdir -p passed && make CC='$2' CFLAGS='$3' LDFLAGS='$4' OMP= JOBS=1 $(echo $names) && JOBS=1 PASSED=passed EMULATOR=$emulator sh tests/run.sh '' $(echo $names)"
    turn=2
}
# clang's undefined behaviour knows what gcc's does not: null + 0, and other arithmetic of pointers
if [ "$1" != short ]; then
    for how in "gcc address,undefined" "clang undefined"; do
        sanitize="-fsanitize=${how#* } -fno-sanitize-recover=all"
        if ${how% *} $sanitize $dir/probe.c -o $dir/probe 2>/dev/null; then
            tests "${how% *} -fsanitize=${how#* }" "${how% *}" "-g -O1 -ffp-contract=off $sanitize" "$sanitize"
        else skip "${how% *} has no sanitizers (Debian package gcc, or libclang-rt-dev for clang)"; fi
    done
    found tcc && tests tcc tcc
    found clang && tests "clang -O2" clang "-std=c99 -O2 -ffp-contract=off"
    # processors that can fuse a product and a sum, and compilers that would
    found clang && try "clang -O3 -march=native: test_threads" "clang -O3 -march=native -I. tests/run/test_threads.c -o \$bin -lm && \$bin"
    found gcc && try "gcc -O2: the AVX2 version of every kernel uses vector arithmetic" "sh tests/vector.sh \$bin.o"
    found gcc && try "gcc -std=gnu99 -O3 -march=native: test_threads" "gcc -std=gnu99 -O3 -march=native -I. tests/run/test_threads.c -o \$bin -lm && \$bin"
    found g++ && tests "g++ -std=c++11" g++ "-std=c++11 -O2 -ffp-contract=off"
    try "the same bits on Windows, aarch64, WebAssembly" "sh tests/cross.sh \$bin"
    turn=1
    # as they are written they take two hours: make studies-check LONG=1
    try "every documented command of the studies, in its short form" \
        "mkdir -p \$bin/build && for f in Makefile README.md bench dem.h docs examples src tests; do ln -sfn \$PWD/\$f \$bin/\$f; done &&" \
        "cc -O2 -c dem.c -o \$bin/dem.o && for p in \$(sed -n 's/^programs=\"\(.*\)\"/\1/p' tests/studies.sh); do" \
        "cc -O2 -I. examples/\$p.c \$bin/dem.o -o \$bin/build/\$p -lm || exit 1; done && cd \$bin && JOBS=1 sh tests/studies.sh"
    turn=2
    try "outside: make new, make install, pkg-config, CMake" "sh tests/outside.sh \$bin"
    if found node && { found wasm-ld || found wasm-ld-14; }; then
        try "the pages: the same digests, curves and exam in node, in a browser and native" "sh tests/web.sh \$bin.web; code=\$?; rm -rf \$bin.web; exit \$code"
    else skip "no compiler for WebAssembly, or no node (Debian packages clang, lld, wasi-libc, libclang-rt-14-dev-wasm32, nodejs)"; fi
    if found chromium; then
        try "replays play in a headless chromium" "cc -O1 -I. -DDEM_IMPLEMENTATION tests/write_replays.c -o \$bin -lm && REPLAYS=\$bin sh tests/browser.sh"
    else skip "chromium not found (Debian package chromium)"; fi
    emulator=$run32
    [ "$run32" = qemu-i386 ] && skip "gcc -m32: tests: this kernel runs no 32-bit programs, and in qemu-i386 they take hours"
    [ "$run32" = none ] ||
    tests "gcc -m32" gcc "-m32 -msse2 -mfpmath=sse -std=c99 -O2 -ffp-contract=off" -m32
fi

# run them, JOBS at a time, and tell
cat > $dir/one <<'X'
name=$(sed -n '1s/# //p' "$1")
cmp -s "$1" "$1.ok" && exit                    # passed before the interruption
grep -q PASSED= "$1" || rm -rf "${1%.sh}.bin"  # folders of tests know which programs passed
if sh "$1" > "$1.log" 2>&1; then echo "ok    $name"; cp "$1" "$1.ok"; rm -rf "${1%.sh}.bin" "${1%.sh}.bin.o"
else echo "FAIL  $name"; { sed 1d "$1"; sed -n "/FAILED\|rror:\|ERROR\|undefined ref/,\$p" "$1.log" | head -n 12; tail -n 1 "$1.log"; } | cut -c1-200 | sed "s/^/      | /"; fi
X
for case in $dir/*.sh; do
    sed -n '1s/# //p' $case | grep -E -e "${CASES:-.}" | grep -qvE -e "${NOT:-^$}" || { rm $case; left=$((left + 1)); }
done
[ $left -eq 0 ] || skip "$left cases that CASES and NOT leave out"
ls $dir/*.sh | xargs -P "$JOBS" -n 1 sh $dir/one
echo
for case in $dir/*.sh; do cmp -s $case $case.ok || sed -n '1s/# /FAILED: /p' $case; done
cases=$(ls $dir/*.sh | wc -l); passed=$(for case in $dir/*.sh; do cmp -s $case $case.ok && echo $case; done | wc -l)
echo "check: $((passed)) passed, $((cases - passed)) failed, $skipped skipped"
[ "$passed" -eq "$cases" ]
