#!/usr/bin/env bash
# Installs, moves the installed tree, then builds and runs the embedding example from that tree alone.
set -eu
[[ $PWD != "$BARCHAN_SOURCE" ]] || { echo "run this in a folder of its own"; exit 1; }
work=$PWD
rm -rf "$work"/staged "$work"/installed "$work"/embed "$work"/embed_build

cmake --install "$BARCHAN_BUILD" --prefix "$work/staged" > install.log
mv staged installed
for path in bin/barchan bin/barchan-netlab libexec/barchan/netlab/netlab_forwarder include/barchan/core/base/vec.hpp share/barchan/examples/embed/CMakeLists.txt; do
  [[ -e installed/$path ]] || { echo "not installed: $path"; exit 1; }
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
