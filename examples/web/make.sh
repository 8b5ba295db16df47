# sh examples/web/make.sh DIR: compiles lesson.c to WebAssembly and puts it into its page, DIR/lesson.html; beside it
# the program of the same sources, DIR/lesson, whose digests are the page's. Needs clang with the WebAssembly parts
# below. Ends with 77 after a SKIP line where they are not there.
dir=$1; here=$(dirname "$0"); mkdir -p "$dir" || exit 1
wasm="${WASM_CC:-clang} --target=wasm32-wasi --sysroot=${WASM_SYSROOT:-/usr} -mexec-model=reactor -msimd128"
echo 'double sin(double); double lesson(double x) { return sin(x); }' > "$dir/probe.c"
if ! $wasm "$dir/probe.c" -o "$dir/probe.wasm" -lm > "$dir/probe.log" 2>&1; then
    echo "SKIP: no compiler for WebAssembly (Debian packages clang, lld, wasi-libc, libclang-rt-14-dev-wasm32)"; exit 77
fi
rm -f "$dir/probe.c" "$dir/probe.wasm" "$dir/probe.log"
both="-std=c99 -O3 -ffp-contract=off -DDEM_NO_OPENMP -DDEM_IMPLEMENTATION"      # no products fused: the same bits
$wasm $both -Wl,-z,stack-size=1048576 -Wl,--strip-all "$here/lesson.c" -o "$dir/lesson.wasm" -lm || exit 1
${CC:-cc} $both "$here/lesson.c" -o "$dir/lesson" -lm || exit 1
base64 "$dir/lesson.wasm" > "$dir/lesson.b64" || exit 1
awk -v code="$dir/lesson.b64" '$0 == "@wasm@" { while ((getline line < code) > 0) print line; next } { print }' \
    "$here/lesson.html" > "$dir/lesson.html.part" && mv "$dir/lesson.html.part" "$dir/lesson.html" || exit 1
rm -f "$dir/lesson.wasm" "$dir/lesson.b64"
echo "open $dir/lesson.html in a browser: $(($(wc -c < "$dir/lesson.html")/1024)) kB, no network and no server needed"
