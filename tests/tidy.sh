#!/usr/bin/env bash
# clang-tidy: tests/tidy.sh [BUILD_FOLDER [UNIT_REGEX]]. Every finding is an error. comm and tasks go as one unit each, which reads
# headers once; so no two of their sources have different things of one name. They are clean, and part of the suite (house.tidy).
# Sources of core and app go one by one, which takes half an hour; some of their functions are too long.
set -u
cd "${BARCHAN_SOURCE:-$(dirname "$0")/..}" || exit 1
export build=${1:-build/release}
pattern=${2:-.}
tidy=$(command -v clang-tidy-14 || command -v clang-tidy) ||
  { echo "clang-tidy is not installed"; exit 77; }
[[ -f $build/compile_commands.json ]] ||
  { echo "$build/compile_commands.json is missing: cmake --preset release writes it"; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export tidy work

# flags_of SOURCE: what the build compiles it with, but for warnings.
flags_of() {
  python3 - "$PWD/$1" "$build" <<'END'
import json, shlex, sys
entry = next(e for e in json.load(open(sys.argv[2] + "/compile_commands.json")) if e["file"] == sys.argv[1])
words = shlex.split(entry["command"])
print("\n".join(w for w in words if w.startswith(("-D", "-I", "-m", "-std")) or w.startswith("/") and
               words[words.index(w) - 1] == "-isystem" or w == "-isystem"))
END
}
export -f flags_of

# check_unit NAME SOURCE...: the sources as one.
check_unit() {
  local unit=$work/${1//\//_}.cpp layer=${1%%/*}
  local -a flags
  shift
  printf "#include \"$PWD/%s\"\n" "$@" > "$unit"
  mapfile -t flags < <(flags_of "$1")
  "$tidy" --quiet --config-file=.clang-tidy --checks=-bugprone-suspicious-include --header-filter="/$layer/" "$unit" -- \
    "${flags[@]}" -w 2> >(grep -v 'warnings\? generated\|^Suppressed\|^Use -' >&2)
}
export -f check_unit

# A unit a line: its name, its sources.
units() {
  local layer
  for layer in comm tasks; do echo "$layer" $(find $layer -name '*.cpp' | sort); done
  find core app -name '*.cpp' | grep -v "$([[ $(uname -m) == x86_64 ]] && echo '^$' || echo avx)" | sort | sed 's/.*/& &/'
}
units | grep -E "$pattern" | xargs -r -L 1 -P "$(nproc)" bash -c 'check_unit "$@"' check_unit
