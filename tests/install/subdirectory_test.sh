#!/usr/bin/env bash
# A project that adds this one as a subdirectory, or by FetchContent, configures, gets no tests or command, and compiles against it.
set -eu
[[ $PWD != "$BARCHAN_SOURCE" ]] || { echo "run this in a folder of its own: it removes ./build"; exit 1; }
rm -rf build fetched
cmake -S "$BARCHAN_SOURCE/tests/install/subdirectory" -B build -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DBARCHAN_SOURCE="$BARCHAN_SOURCE"
targets=$(cmake --build build --target help)
if grep -E '^(unit_tests|mpi_tests|barchan_app):' <<< "$targets"; then
  echo "tests or the command are part of another project's build"
  exit 1
fi
cmake -S "$BARCHAN_SOURCE/tests/install/subdirectory" -B fetched -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DBARCHAN_SOURCE="$BARCHAN_SOURCE" -DBARCHAN_IS_FETCHED=ON > fetched.log
cmake --build fetched --target help | grep -q '^barchan_cpp:' || { echo "no library by FetchContent"; exit 1; }
# Linking is what the install test shows; building every layer again would only take time.
cmake --build build --target CMakeFiles/consumer.dir/main.cpp.o
