#!/usr/bin/env bash
# AddressSanitizer, LeakSanitizer and UndefinedBehaviorSanitizer over all unit tests, the MPI tests on two ranks, and the
# command on two small decks. Any report ends its program with a status that is not 0, and so this script with 1.
#
# usage: tests/sanitizers/asan_ubsan.sh [FILTER]     FILTER: of GoogleTest, for a part
#        tests/sanitizers/asan_ubsan.sh --part       what the suite runs: part.cpp, on one rank and on two
#
# The whole builds the tree once more: more than six minutes on two cores with other work. The part takes core from the fuzzing
# targets, which are built with the same sanitizers by clang++ (tests/fuzz/fuzz build). Suppressed are leaks of Open MPI alone: lsan.supp.
set -u
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh"
filter=${1:-*}
# Leaks of MPI's components are told by frames deep in the stack, so stacks are unwound slowly but wholly.
export ASAN_OPTIONS=fast_unwind_on_malloc=0:detect_stack_use_after_return=1:strict_string_checks=1
export UBSAN_OPTIONS=print_stacktrace=1
export LSAN_OPTIONS=suppressions=$here/lsan.supp:print_suppressions=0

if [[ $filter == --part ]]; then
  build_part fuzz
  step "one rank, 2 threads" "$part/sanitized_part" 2
  for exchange in put-flag isend; do
    step "2 ranks, 2 threads, $exchange" mpirun -n 2 "$part/sanitized_part" 2 "$exchange"
  done
  finish
  exit 0
fi
build asan-ubsan unit_tests mpi_tests barchan
cd "$work" || exit 1
bin=$source/build/asan-ubsan
step "unit tests" "$bin/tests/unit_tests" --gtest_filter="$filter" --gtest_brief=1
step "MPI tests, 2 ranks" mpirun -n 2 "$bin/tests/mpi_tests" --gtest_filter="$filter" --gtest_brief=1
for deck in soil_duct column_collapse; do
  step "$deck, 2 ranks, 2 threads" mpirun -n 2 "$bin/barchan" run "$source/examples/$deck.toml" --steps 400 --threads 2 \
    --set checkpoint.every_steps=100 --set output.snapshots_every=100 --out "$deck" --quiet
  step "$deck, gone on" "$bin/barchan" run "$source/examples/$deck.toml" --steps 500 --threads 1 \
    --set checkpoint.every_steps=100 --set output.snapshots_every=100 --out "$deck" --restart auto --quiet
done
finish
