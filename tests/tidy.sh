#!/usr/bin/env bash
# clang-tidy over the sources of the layers: tests/tidy.sh [BUILD_FOLDER [PATH_REGEX]]. Takes minutes, so it is not
# part of the suite; every finding is an error.
set -u
cd "$(dirname "$0")/.." || exit 1
build=${1:-build/release}
pattern=${2:-.}
tidy=$(command -v clang-tidy-14 || command -v clang-tidy) ||
  { echo "clang-tidy is not installed"; exit 77; }
[[ -f $build/compile_commands.json ]] ||
  { echo "$build/compile_commands.json is missing: cmake --preset release writes it"; exit 1; }

find core comm tasks app -name '*.cpp' | sort | grep -E "$pattern" |
  xargs -r -n 1 -P "$(nproc)" "$tidy" -p "$build" --quiet 2> >(grep -v 'warnings\? generated' >&2)
