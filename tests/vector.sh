# sh tests/vector.sh OBJECT: compiles dem.c at -O2 as users do, and lists the kernels (DEMI_CLONES) whose AVX2 version
# the compiler has not vectorised: those with less vector than scalar arithmetic. Loops for rare settings of laws
# (those whose names end in _all) may be scalar, but not wholly.
command -v objdump >/dev/null || { echo "SKIP: objdump not found (Debian package binutils)"; exit 0; }
[ "$(uname -m)" = x86_64 ] || { echo "SKIP: kernels have an AVX2 version on x86_64 only"; exit 0; }
gcc -std=gnu99 -O2 -fopenmp -I. -c dem.c -o "$1" && objdump -d --no-show-raw-insn "$1" | awk '
    /^[0-9a-f]+ <.*\.avx2>:/ { name = $2; kernels++; packed = scalar = 0 }
    name && /v(mul|add|sub|div|sqrt)pd/ { packed++ }
    name && /v(mul|add|sub|div|sqrt)sd/ { scalar++ }
    /^$/ && name {
        if (name ~ /_all\./ ? scalar && !packed : scalar > packed) { print "not vectorised: " name " " scalar " scalar, " packed + 0 " vector operations"; bad = 1 }
        name = ""
    }
    END { if (kernels < 40) { print "only " kernels + 0 " kernels found"; bad = 1 } else print kernels " kernels"; exit bad }'
