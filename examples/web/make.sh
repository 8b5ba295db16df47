# sh examples/web/make.sh DIR: compiles lesson.c and lab.c to WebAssembly and puts each into its page, DIR/lesson.html and
# DIR/lab.html; beside them the programs of the same sources, DIR/lesson and DIR/lab, whose digests are the pages'.
# Needs clang with the WebAssembly parts below. Ends with 77 and a message where they are not there.
#    sh examples/web/make.sh --digest prints the digest of the sources that the last line of each page has.
here=$(dirname "$0")
digest=$(cd "$here" && cat make.sh lesson.c lesson.html lab.c lab.html lab_row.h translate.js engine.js ../exam.h ../exam_curves.h \
    ../laws/*.h | cksum | cut -d' ' -f1)
[ "$1" = --digest ] && { echo "$digest"; exit 0; }
dir=$1; mkdir -p "$dir" || exit 1
wasm="${WASM_CC:-clang} --target=wasm32-wasi --sysroot=${WASM_SYSROOT:-/usr} -msimd128"; reactor=-mexec-model=reactor
echo 'double sin(double); double lesson(double x) { return sin(x); }' > "$dir/probe.c"
if ! $wasm $reactor "$dir/probe.c" -o "$dir/probe.wasm" -lm > "$dir/probe.log" 2>&1; then
    echo "no compiler for WebAssembly: install the Debian packages clang, lld, wasi-libc and libclang-rt-14-dev-wasm32"; exit 77
fi
rm -f "$dir/probe.c" "$dir/probe.wasm" "$dir/probe.log"
both="-std=c99 -O2 -ffp-contract=off -DDEM_NO_OPENMP -DDEM_CORE"                # no products fused: the same bits
clock="-D_WASI_EMULATED_PROCESS_CLOCKS"                                         # the exam measures its time
$wasm $both $clock -c "$here/../../dem.c" -o "$dir/dem.wasm.o" && ${CC:-cc} $both -c "$here/../../dem.c" -o "$dir/dem.o" || exit 1
# what the lab knows of dem.h: its public part, without comments and system headers, and two macros
{ printf '#define DEM_R(x) ((dem_real)(x))\n#define DEM_INLINE static inline\n#define DEM_VEC3(x, y, z) dem_vec3_make(x, y, z)\n'
  printf '#include "dem.h"\n#include "lab_row.h"\n' > "$dir/header.c"
  $wasm $both -I "$here/../.." -I "$here" -E "$dir/header.c" |
      awk '/^# [0-9]+ "/ { on = /(dem|lab_row)\.h"/; next } on && NF' | sed 's/  */ /g'
} > "$dir/header.txt" && grep -q 'lab_row;' "$dir/header.txt" || exit 1
for page in lesson lab; do
    $wasm $reactor $both $clock -Wl,-z,stack-size=1048576 -Wl,--strip-all "$here/$page.c" "$dir/dem.wasm.o" -o "$dir/$page.wasm" -lm \
        -lwasi-emulated-process-clocks || exit 1
    ${CC:-cc} $both "$here/$page.c" "$dir/dem.o" -o "$dir/$page" -lm || exit 1
    gzip -9 -n -c "$dir/$page.wasm" | base64 > "$dir/$page.b64" || exit 1
    # lines @name@ are replaced by files; those of laws by the shipped laws, each between two lines
    awk -v dir="$dir" -v here="$here" -v page="$page" '
        function paste(file) { while ((getline line < file) > 0) print line; close(file) }
        FILENAME != ARGV[1] { exit }
        $0 == "@wasm@" { paste(dir "/" page ".b64"); next }
        $0 == "@header@" { paste(dir "/header.txt"); next }
        $0 == "@translate@" { paste(here "/translate.js"); next }
        $0 == "@engine@" { paste(here "/engine.js"); next }
        $0 == "@laws@" { for (k = 2; k < ARGC; k++) { name = ARGV[k]; sub(/.*\//, "", name)
            print "<script type=\"text/plain\" class=\"law\" data-name=\"" name "\">"; paste(ARGV[k]); print "</script>" } next }
        { print }' "$here/$page.html" "$here"/../laws/*.h > "$dir/$page.html.part" || exit 1
    echo "<!-- sources $digest, dem.h $(cksum < "$here/../../dem.h" | cut -d' ' -f1) -->" >> "$dir/$page.html.part"
    mv "$dir/$page.html.part" "$dir/$page.html" || exit 1
    rm -f "$dir/$page.wasm" "$dir/$page.b64"
    echo "open $dir/$page.html in a browser: $(($(wc -c < "$dir/$page.html")/1024)) kB, no network and no server needed"
done
rm -f "$dir/dem.wasm.o" "$dir/dem.o" "$dir/header.c"
