# sh bench/compile.sh: processor time that compiling dem.c takes, s, by compiler and level. COMPILERS="gcc clang tcc". Then
# lines, time and code of the whole and of DEM_CORE (gcc -O2): what README's table of builds shows.
seconds='{ for (k = 1; k <= 2; k++) { split($k, t, /[ms]/); s += 60*t[1] + t[2] } printf "%s = %.2f s\n", name, s }'
mkdir -p build
for cc in ${COMPILERS:-gcc clang tcc}; do
    command -v $cc >/dev/null || { echo "SKIP: $cc not found (Debian package $cc)"; continue; }
    case $cc in tcc) levels=-O0 ;; *) levels="-O0 -O2 -O3" ;; esac
    for level in $levels; do                    # times: of the shell, then of what it ran, user and system
        sh -c "$cc $level -std=c99 -I. -c dem.c -o build/compile.o; times" | tail -n 1 |
            awk -v name="compile.$cc.${level#-}" "$seconds"
    done
done
for part in whole core; do
    switch=; [ $part = core ] && switch=-DDEM_CORE
    awk -v core="$switch" '/^#if/ { off[++depth] = off[depth - 1] || (core && /^#ifndef DEM_NO_[A-Z]*$/ && NR > start) }
        /^#ifndef DEM_H$/ { start = NR } !off[depth] { n++ } /^#endif/ { depth-- } END { print "lines.'$part' = " n }' dem.h
    sh -c "gcc -O2 -std=c99 -I. $switch -c dem.c -o build/compile.o; times" 2>/dev/null | tail -n 1 |
        awk -v name="compile.$part" "$seconds"
    nm -S -t d build/compile.o | awk '$3 ~ /[tT]/ { n += $2 } END { printf "code.'$part' = %.0f kB\n", n/1000 }'
done
rm -f build/compile.o
