# COMPILE=... LINK=... sh tests/snippets.sh: compiles the programs and parts that tests/snippets.awk took out of the manual
# and the pages into build/snippets, JOBS (1) at a time. It runs the programs of docs/how_to*.md, each in a folder of its
# own, and compares what they print with what their page shows.
# The last line is "N passed, N failed"; the exit code is 1 when anything failed.
dir=build/snippets
if [ "$1" = -one ]; then                       # FILE
    name=${2%.c}; here=$PWD
    fails() { printf 'FAILED %s\n' "$1"; [ ! -f "$name.log" ] || sed 's/^/       | /' "$name.log"; exit 0; }
    case $name in
    *_part) $COMPILE -O0 -c -o "$name.o" "$2" > "$name.log" 2>&1 ;;
    *) $COMPILE -O0 -o "$name" "$2" $(grep -q DEM_IMPLEMENTATION "$2" || echo build/dem.o) $LINK > "$name.log" 2>&1 ;;
    esac || fails "$name does not compile"
    case $name in */how_to*_program)
        mkdir -p "$name.run/examples/data" && cp examples/data/hopper.stl "$name.run/examples/data"
        (ulimit -t 60; cd "$name.run" && "$here/$name") > "$name.log" 2>&1 || fails "$name ends with code $?"
        [ ! -f "$name.expected" ] || awk -f tests/printed.awk "$name.expected" "$name.log" ||
            fails "$name does not print what its page shows" ;;
    esac
    echo "ok     $name"
    exit 0
fi
export OMP_WAIT_POLICY=passive                 # several programs share the cores: a thread that waits sleeps
ls $dir/*_program.c $dir/*_part.c | xargs -P "${JOBS:-1}" -n 1 sh "$0" -one | tee $dir/log
awk -v programs="$(ls $dir/*_program.c $dir/*_part.c | wc -l)" '/^ok/ { passed++ }
    END { print passed + 0 " passed, " programs - passed " failed"; exit passed < programs || programs == 0 }' $dir/log
