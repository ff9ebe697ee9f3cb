# For the scripts beside: environment, build, and steps that are timed and counted.
source=${BARCHAN_SOURCE:-$(cd "$here/../.." && pwd)}
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
export OMPI_MCA_mpi_yield_when_idle=1 OMPI_MCA_hwloc_base_binding_policy=none
export BARCHAN_TEST_SECONDS=${BARCHAN_TEST_SECONDS:-600}
failures=()

# build PRESET TARGET...: into build/PRESET
build() {
  local preset=$1 launcher=()
  shift
  if command -v ccache > /dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
  cd "$source" && cmake --preset "$preset" "${launcher[@]}" > /dev/null &&
    cmake --build "build/$preset" --parallel "$(nproc)" --target "$@" || exit 1
}

# build_part NAME CMAKE_OPTION...: the small program of the suite (CMakeLists.txt), in build/NAME
build_part() {
  part=${BARCHAN_BUILD:-$source/build}/$1 launcher=()
  shift
  if command -v ccache > /dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
  cmake -S "$source" -B "$part" -G Ninja -DBARCHAN_BUILD_SANITIZED=ON -DBARCHAN_BUILD_TESTS=OFF -DBARCHAN_BUILD_COMMAND=OFF \
    -DBARCHAN_BUILD_BENCH=OFF -DBARCHAN_INSTALL=OFF "${launcher[@]}" "$@" > "$work/output" || { cat "$work/output"; exit 1; }
  cmake --build "$part" --target sanitized_part --parallel "$(nproc)" > "$work/output" || { tail -40 "$work/output"; exit 1; }
  echo "build: $SECONDS s"
  cd "$work" || exit 1
}

# step NAME COMMAND...: any status but 0 is a failure; reports go to the standard error output as they come
step() {
  local name=$1 begin=$SECONDS status=0
  shift
  "$@" > "$work/output" || status=$?
  echo "$name: $((SECONDS - begin)) s, status $status"
  if ((status != 0)); then
    tail -40 "$work/output"
    failures+=("$name")
  fi
}

finish() {
  if ((${#failures[@]} > 0)); then
    printf 'FAILED: %s\n' "${failures[@]}"
    exit 1
  fi
  echo "no report"
}

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
