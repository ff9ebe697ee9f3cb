#!/usr/bin/env bash
# ThreadSanitizer over the step graph: one rank with two and three threads, by the command and by the MPI tests.
# Any report ends its program with status 66, and so this script with 1.
#
# usage: tests/sanitizers/tsan.sh [FILTER]           FILTER: of GoogleTest, for a part of the MPI tests
#        tests/sanitizers/tsan.sh --part             what the suite runs: part.cpp with two threads
#
# Debian's oneTBB and Open MPI are built without ThreadSanitizer. What they do by themselves is not judged
# (ignore_noninstrumented_modules, tsan.supp); the orders that oneTBB makes between tasks are told by tell_release and
# tell_acquire in tasks/task_graph.cpp, edge by edge, so that two tasks without an edge between them are still a race.
# Tried with races planted for it: a counter that the tasks of all lanes share in a rebuild, and a chunk of a step
# that writes what belongs to the next lane, were each reported; without them nothing was.
#
# The whole builds the tree once more: more than six minutes on two cores with other work, and three to run.
set -u
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh"
filter=${1:-SameBits.*:StepGraph.*}
export TSAN_OPTIONS=ignore_noninstrumented_modules=1:history_size=7:suppressions=$here/tsan.supp:print_suppressions=0

if [[ $filter == --part ]]; then
  build_part tsan-part -DBARCHAN_SANITIZED_REST="${BARCHAN_BUILD:-$source/build/release}" -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1 -fno-omit-frame-pointer" \
    -DCMAKE_CXX_FLAGS=-fsanitize=thread
  step "one rank, 2 threads" "$part/sanitized_part" 2
  finish
  exit 0
fi
build tsan mpi_tests barchan
cd "$work" || exit 1
bin=$source/build/tsan
run() {
  local name=$1 deck=$2
  shift 2
  step "$name" "$bin/barchan" run "$source/examples/$deck.toml" --set output.picture=false --out run --force --quiet "$@"
}
run "soil_duct, 2 threads, plate, bonds" soil_duct --threads 2 --steps 1000 --set stage.settle.max_time=0.1
run "soil_duct, 2 threads, checkpoints" soil_duct --threads 2 --steps 500 --set checkpoint.every_steps=50
run "soil_duct, 2 threads, trace" soil_duct --threads 2 --steps 300 --trace
run "column_collapse, 2 threads" column_collapse --threads 2 --steps 200
run "column_collapse, 3 threads, sequential" column_collapse --threads 3 --steps 200 --schedule sequential
step "MPI tests, 1 rank" "$bin/tests/mpi_tests" --gtest_filter="$filter" --gtest_brief=1
finish
