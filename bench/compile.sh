# sh bench/compile.sh: processor time that compiling dem.c takes, s, by compiler and level. COMPILERS="gcc clang tcc".
mkdir -p build
for cc in ${COMPILERS:-gcc clang tcc}; do
    command -v $cc >/dev/null || { echo "SKIP: $cc not found (Debian package $cc)"; continue; }
    case $cc in tcc) levels=-O0 ;; *) levels="-O0 -O2 -O3" ;; esac
    for level in $levels; do                    # times: of the shell, then of what it ran, user and system
        sh -c "$cc $level -std=c99 -I. -c dem.c -o build/compile.o; times" | tail -n 1 |
            awk -v name="compile.$cc.${level#-}" '{ for (k = 1; k <= 2; k++) { split($k, t, /[ms]/); s += 60*t[1] + t[2] }
                printf "%s = %.2f s\n", name, s }'
    done
done
rm -f build/compile.o
