#!/usr/bin/env bash
# Installs, moves the installed tree, then builds and runs the examples in C++, C, Fortran and Python from that tree alone.
set -eu
[[ $PWD != "$BARCHAN_SOURCE" ]] || { echo "run this in a folder of its own"; exit 1; }
work=$PWD
rm -rf "$work"/staged "$work"/installed "$work"/embed "$work"/embed_build "$work"/bits "$work"/bits_build

cmake --install "$BARCHAN_BUILD" --prefix "$work/staged" > install.log
mv staged installed
for path in bin/barchan bin/barchan-netlab libexec/barchan/netlab/netlab_forwarder share/man/man1/barchan-run.1 \
  share/barchan/deck.schema.json \
  include/barchan/core/base/vec.hpp share/barchan/examples/embed/CMakeLists.txt; do
  [[ -e installed/$path ]] || { echo "not installed: $path"; exit 1; }
done
for private in tasks/engine.hpp core/brick/brick.hpp core/kernels/pair_loop.hpp; do
  [[ ! -e installed/include/barchan/$private ]] || { echo "a private header is installed: $private"; exit 1; }
done
[[ -L installed/include/barchan/core ]] && { echo "headers are installed as links"; exit 1; }
installed/bin/barchan --version
installed/bin/barchan-netlab --help > netlab.txt

cp -r installed/share/barchan/examples/embed embed
cmake -S embed -B embed_build -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_EXPORT_COMPILE_COMMANDS=ON \
  -DCMAKE_CXX_FLAGS="${CXXFLAGS:-}" -DCMAKE_PREFIX_PATH="$work/installed"
cmake --build embed_build
if grep -E "$BARCHAN_SOURCE/(core|comm|tasks|include)|$BARCHAN_BUILD/(include|lib)" embed_build/build.ninja; then
  echo "the example was built from the source tree, not from the installed one"
  exit 1
fi
mpirun -n 2 embed_build/embed
if grep -qE 'ffp-contract|tree-slp' embed_build/compile_commands.json; then
  echo "flags of barchan's reach the program"
  exit 1
fi
# Flags of the program's own leave barchan's bits alone, also where both have compiled an inline function.
mkdir -p bits
cat > bits/CMakeLists.txt <<EOF
cmake_minimum_required(VERSION 3.24)
project(bits LANGUAGES CXX)
find_package(barchan REQUIRED)
add_executable(bits $BARCHAN_SOURCE/tests/install/bits.cpp)
target_link_libraries(bits PRIVATE barchan::barchan)
target_compile_options(bits PRIVATE -O1 -march=native -ffast-math -fno-inline)
target_link_options(bits PRIVATE -ffast-math)
# The adapter for preCICE, where that is not installed against a header that stands in, with a partner that is known.
add_executable(precice_wall $work/installed/share/barchan/examples/precice/precice_wall.cpp)
target_include_directories(precice_wall PRIVATE $BARCHAN_SOURCE/tests/install/stand_in)
target_link_libraries(precice_wall PRIVATE barchan::barchan)
EOF
cmake -S bits -B bits_build -G Ninja -DCMAKE_CXX_FLAGS="${CXXFLAGS:-}" -DCMAKE_PREFIX_PATH="$work/installed" > bits.log
cmake --build bits_build >> bits.log
for ranks in 1 2; do
  pushed=$(mpirun -n $ranks bits_build/precice_wall installed/share/barchan/examples/precice/wall.toml lid none.xml)
  [[ $pushed == *" 100 N" ]] || { echo "the spring of 5e4 N/m by two contacts of 1e5 N/m is due 100 N: $pushed"; exit 1; }
done
installed/bin/barchan run "$BARCHAN_SOURCE/tests/install/abi.toml" --quiet --out bits.out --force --set time.end=0.06
digest=$(mpirun -n 2 bits_build/bits "$BARCHAN_SOURCE/tests/install/abi.toml")
grep -q "\"state_digest\": \"$digest\"" bits.out/run.json ||
  { echo "flags of a program have changed bits: $digest instead of $(grep state_digest bits.out/run.json)"; exit 1; }
readelf -rW installed/lib*/libbarchan_cpp.so > relocations.txt
grep -q JUMP_SLO relocations.txt || { echo "readelf names no function that libbarchan_cpp.so calls"; exit 1; }
loose=$(grep JUMP_SLO relocations.txt | grep -c 7barchan || true)
[[ $loose == 0 ]] || { echo "libbarchan_cpp.so calls $loose functions of its own that a program may replace"; exit 1; }

grep -q '^BARCHAN_BUILD_BINDINGS:BOOL=ON' "$BARCHAN_BUILD/CMakeCache.txt" || exit 0  # as with sanitizers

# C through pkg-config, with flags that must not reach barchan's arithmetic; another compiler, where there is one.
export PKG_CONFIG_PATH LD_LIBRARY_PATH
PKG_CONFIG_PATH=$(dirname "$work"/installed/lib*/pkgconfig/barchan.pc)
LD_LIBRARY_PATH=$(dirname "$PKG_CONFIG_PATH")${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
read -ra flags <<< "$(pkg-config --cflags --libs barchan) $(pkg-config --cflags --libs ompi-c) -lm"
coupling=$work/installed/share/barchan/examples/coupling
cc -std=c99 -Wall -Wextra -Werror -pedantic "$BARCHAN_SOURCE/tests/install/abi.c" -o abi "${flags[@]}"
cc -O3 -march=native -ffast-math "$BARCHAN_SOURCE/tests/install/abi.c" -o abi_fast "${flags[@]}"
programs="abi abi_fast"
if command -v clang > /dev/null; then
  clang -std=c11 -O2 "$BARCHAN_SOURCE/tests/install/abi.c" -o abi_clang "${flags[@]}"
  programs+=" abi_clang"
fi
digests=$(for program in $programs; do for ranks in 1 2 3; do
  mpirun -n "$ranks" "./$program" "$BARCHAN_SOURCE/tests/install/abi.toml" || echo "$program failed on $ranks ranks"
done; done | sort -u)
[[ $digests =~ ^[0-9a-f]{16}$ ]] || { printf 'not one digest from C, whatever flags and ranks:\n%s\n' "$digests"; exit 1; }
cc -Wall -Wextra -Werror "$coupling/sink.c" -o sink "${flags[@]}"
mpirun -n 2 ./sink "$coupling/fluid.toml"
cc -O2 -std=c99 -Wall -Wextra -Werror -pedantic "$coupling/fluidised_bed.c" -o fluidised_bed "${flags[@]}"
mpirun -n 2 ./fluidised_bed "$coupling/bed.toml" implicit
if command -v mpifort > /dev/null && command -v gfortran > /dev/null; then
  mpifort "$coupling/sink.f90" -o sink_fortran "${flags[@]}"
  mpirun -n 2 ./sink_fortran "$coupling/fluid.toml"
fi
packages=$work/installed/lib/python3/dist-packages
if compgen -G "$packages/barchan/_barchan*.so" > /dev/null && /usr/bin/python3 -c 'import numpy' 2> /dev/null; then
  for program in coupling/sink.py python/parameter_study.py; do
    PYTHONPATH=$packages /usr/bin/python3 "$work/installed/share/barchan/examples/$program"
  done
fi
exported=$(nm -D --defined-only "${LD_LIBRARY_PATH%%:*}/libbarchan.so" | grep -cv -e ' barchan_' -e ' BARCHAN_' || true)
[[ $exported == 0 ]] || { echo "libbarchan.so exports $exported names that are not of barchan.h"; exit 1; }
