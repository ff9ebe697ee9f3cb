#!/usr/bin/env bash
# No test or benchmark has left files in the source tree outside build/.
set -u
cd "${BARCHAN_SOURCE:-$(dirname "$0")/..}" || exit 1
litter=$(
  find . -maxdepth 1 \( -name '*.toml' -o -name '*.csv' -o -name '*.data' -o -name '*.dot' -o -name '*.svg' -o -name '*.png' \
    -o -name '*.vtp' -o -name '*.log' -o -name 'run.json' -o -name 'trace.json' -o -name 'case_*' -o -name 'found_*' \)
  find tests docs core comm tasks app \( -name '*.out' -o -name 'run.json' -o -name 'found_*' \) -not -path 'tests/fuzz/corpus/*'
)
[[ -z $litter ]] || { printf 'left in the source tree:\n%s\n' "$litter"; exit 1; }
