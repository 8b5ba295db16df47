# sh tests/outside.sh DIR: dem.h as a small project outside would use it, in DIR: the program of `make new`, through
# `make install` and pkg-config, through CMake's find_package, and through add_subdirectory: the same numbers each time.
set -e
dir=$(mkdir -p "$1" && cd "$1" && pwd); top=$PWD
rm -rf "$dir"/*
make -s new NAME="$dir/my" > /dev/null
if make -s new NAME="$dir/my" > /dev/null 2>&1; then echo "a file was overwritten"; exit 1; fi
make -s install PREFIX="$dir/usr" > "$dir/install.log" 2>&1 || { cat "$dir/install.log"; exit 1; }
# a run without what hangs on the clock: the last line is the state
sed -e 's/return 0;/return 0;/' -e 's/dem_world_destroy(world);/printf("hash %016llx\\n", (unsigned long long)dem_world_hash_get(world)); &/' \
    -e 's/200, 1)/50, 1)/' -e 's#0\.5/60#0.1/60#' "$dir/my.c" > "$dir/main.c"
cd "$dir"
hash() { sed -n 's/^hash //p'; }
cc -O2 -I"$top" -o one main.c "$top/dem.c" -lm && one=$(./one 2> /dev/null | hash)
test -n "$one" && test -s "$dir/my.html" || { echo "no replay"; exit 1; }
if command -v pkg-config > /dev/null; then
    cc -O2 -o two main.c $(PKG_CONFIG_PATH=$dir/usr/lib/pkgconfig pkg-config --cflags --libs dem)
    test "$(./two 2> /dev/null | hash)" = "$one" || { echo "pkg-config: another hash"; exit 1; }
    echo "ok: make install, pkg-config"
else echo "SKIP: pkg-config not found (Debian package pkg-config)"; fi
if command -v cmake > /dev/null; then
    for how in find_package add_subdirectory; do
        mkdir $how
        { echo 'cmake_minimum_required(VERSION 3.13)'; echo 'project(outside C)'
          if [ $how = find_package ]; then echo 'find_package(dem REQUIRED)'; else echo "add_subdirectory($top dem)"; fi
          echo "add_executable(outside $dir/main.c)"; echo 'target_link_libraries(outside dem::dem)'
        } > $how/CMakeLists.txt
        cmake -S $how -B $how/build -DCMAKE_PREFIX_PATH="$dir/usr" > $how/log 2>&1 &&
            cmake --build $how/build >> $how/log 2>&1 || { cat $how/log; exit 1; }
        test "$($how/build/outside 2> /dev/null | hash)" = "$one" || { echo "CMake, $how: another hash"; exit 1; }
        echo "ok: CMake, $how"
    done
else echo "SKIP: cmake not found (Debian package cmake)"; fi
