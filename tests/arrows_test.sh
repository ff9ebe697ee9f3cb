#!/usr/bin/env bash
# Layers include downwards only (core <- comm <- tasks <- app, bindings), and each outside library has one home.
set -u
cd "${BARCHAN_SOURCE:-$(dirname "$0")/..}" || exit 1
status=0

# forbid PATTERN WHY FOLDER...: no #include in these folders matches the pattern.
forbid() {
  local pattern=$1 why=$2 found
  shift 2
  found=$(grep -rnE --include='*.hpp' --include='*.cpp' "^[[:space:]]*#[[:space:]]*include[[:space:]]*$pattern" "$@")
  if [[ -n $found ]]; then
    printf '%s\n%s\n\n' "$why:" "$found"
    status=1
  fi
}

forbid '.barchan/(comm|tasks|app)/' 'core includes no layer above it' core
forbid '.barchan/(tasks|app)/' 'comm includes no layer above it' comm
forbid '.barchan/app/' 'tasks includes no layer above it' tasks
forbid '.barchan/app/' 'bindings stand on tasks, not on the command' bindings
forbid '[<"]mpi(-ext)?\.h' 'only comm includes mpi.h' core tasks app bindings
forbid '[<"](oneapi|tbb)/' 'only tasks includes TBB' core comm app bindings
forbid '[<"]CLI/' 'only app includes CLI11' core comm tasks
forbid '"' 'includes are written <barchan/LAYER/NAME.hpp>' core comm tasks app

calls=$(grep -rnE --include='*.hpp' --include='*.cpp' '\bMPI_[A-Z]' core tasks app)
if [[ -n $calls ]]; then
  printf 'MPI by its own names outside comm:\n%s\n\n' "$calls"
  status=1
fi

missing=$(grep -rLE --include='*.hpp' '^#pragma once' core comm tasks app)
if [[ -n $missing ]]; then
  printf 'headers without #pragma once:\n%s\n' "$missing"
  status=1
fi
exit $status
