# sh tests/install.sh DIR PREFIX CC OMP: what `make install` does. Puts into DIR: include/dem.h, lib/libdem.a (dem.c at
# -O2, for any processor of this kind), lib/pkgconfig/dem.pc and lib/cmake/dem/demConfig.cmake, which say PREFIX.
set -e
dir=$1; prefix=$2; cc=$3; omp=$4
version=$(sed -n '1s/.*version \([0-9.]*\).*/\1/p' dem.h)
mkdir -p "$dir/include" "$dir/lib/pkgconfig" "$dir/lib/cmake/dem" build
$cc -std=c99 -O2 -fno-math-errno $omp -I. -c -o build/install.o dem.c
rm -f build/libdem.a
ar rcs build/libdem.a build/install.o
cp dem.h "$dir/include/dem.h"
cp build/libdem.a "$dir/lib/libdem.a"
cat > "$dir/lib/pkgconfig/dem.pc" <<X
prefix=$prefix
Name: dem
Description: discrete-element simulation in one C99 header
Version: $version
Cflags: -I\${prefix}/include
Libs: -L\${prefix}/lib -ldem $omp -lm
X
cat > "$dir/lib/cmake/dem/demConfig.cmake" <<X
add_library(dem::dem STATIC IMPORTED)
set_target_properties(dem::dem PROPERTIES IMPORTED_LOCATION "$prefix/lib/libdem.a"
    INTERFACE_INCLUDE_DIRECTORIES "$prefix/include" INTERFACE_LINK_LIBRARIES "$omp;m")
X
echo "dem.h $version is in $dir: cc program.c \$(pkg-config --cflags --libs dem), with PKG_CONFIG_PATH=$prefix/lib/pkgconfig"
