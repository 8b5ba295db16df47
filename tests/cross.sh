# sh tests/cross.sh DIR: tests/cross.c built for other systems and processors, run there (wine, qemu, node), and its digest
# compared with this machine's. What is not installed is skipped, loudly. Ends with "N passed, N failed".
dir=$1; mkdir -p "$dir"
flags="-O2 -ffp-contract=off -DDEM_IMPLEMENTATION -I."
cc -std=c99 $flags tests/cross.c -o "$dir/here" -lm || exit 1
here=$("$dir/here"); passed=0; failed=0
echo "this machine: $here"
printf '#include <errno.h>\n#include <math.h>\n#include <stdio.h>\nint main(void) { return printf("%%g", sqrt(errno)) < 0; }\n' > "$dir/probe.c"
try() {                                        # NAME PACKAGES TOOLS BUILD RUN
    for tool in $3; do
        command -v "$tool" > /dev/null || { echo "SKIP: $1: $tool not found (Debian packages $2)"; return; }
    done
    eval "$(echo "$4" | sed "s|tests/cross.c|$dir/probe.c|")" > "$dir/log" 2>&1 ||  # headers and libraries, too?
        { echo "SKIP: $1: cannot build a program (Debian packages $2)"; return; }
    eval "$4" > "$dir/log" 2>&1 || { echo "FAILED $1: does not build"; head -n 5 "$dir/log"; failed=$((failed + 1)); return; }
    there=$(eval "$5" 2> /dev/null | tr -d '\r')
    if [ "$there" = "$here" ]; then echo "ok    $1: the same"; passed=$((passed + 1))
    else echo "FAILED $1: $there"; failed=$((failed + 1)); fi
}
wine=wine; command -v wine64 > /dev/null && wine=wine64
try "Windows, C" "gcc-mingw-w64-x86-64, wine64" "x86_64-w64-mingw32-gcc $wine" \
    "x86_64-w64-mingw32-gcc -std=c99 $flags tests/cross.c -o $dir/c.exe -lm" "WINEDEBUG=-all $wine $dir/c.exe"
try "Windows, C++" "g++-mingw-w64-x86-64, wine64" "x86_64-w64-mingw32-g++ $wine" \
    "x86_64-w64-mingw32-g++ -std=c++11 -x c++ $flags tests/cross.c -o $dir/cpp.exe -static" "WINEDEBUG=-all $wine $dir/cpp.exe"
try "aarch64" "gcc-aarch64-linux-gnu, libc6-dev-arm64-cross, qemu-user" "aarch64-linux-gnu-gcc qemu-aarch64" \
    "aarch64-linux-gnu-gcc -std=c99 $flags -static tests/cross.c -o $dir/arm -lm" "qemu-aarch64 $dir/arm"
cat > "$dir/wasi.mjs" <<'X'
import { WASI } from 'wasi'; import { readFileSync } from 'fs';
const wasi = new WASI({ version: 'preview1', args: ['cross'] });
const { instance } = await WebAssembly.instantiate(readFileSync(process.argv[2]), { wasi_snapshot_preview1: wasi.wasiImport });
wasi.start(instance);
X
try "WebAssembly" "clang, lld, wasi-libc, libclang-rt-14-dev-wasm32, nodejs" "clang wasm-ld-14 node" \
    "clang --target=wasm32-wasi --sysroot=/usr -std=c99 $flags -Wl,-z,stack-size=262144 tests/cross.c -o $dir/cross.wasm -lm" \
    "node --no-warnings $dir/wasi.mjs $dir/cross.wasm"
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
