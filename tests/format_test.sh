#!/usr/bin/env bash
# Holds the tree to .clang-format and to 100 columns. With --fix, formats it instead.
set -u
export LC_ALL=C.UTF-8  # columns, not bytes
cd "${BARCHAN_SOURCE:-$(dirname "$0")/..}" || exit 1
formatter=$(command -v clang-format-14 || command -v clang-format) ||
  { echo "clang-format is not installed"; exit 77; }

mapfile -t files < <(find core comm tasks app bindings tests examples bench \
  \( -name build -o -name '*.out' \) -prune -o \( -name '*.hpp' -o -name '*.cpp' \) -print | sort)
if [[ ${1:-} == --fix ]]; then
  "$formatter" -i "${files[@]}"
  "$formatter" -i "${files[@]}"  # comments that it moved may need a second look
  exit
fi

unformatted=()
for file in "${files[@]}"; do
  "$formatter" --dry-run --Werror "$file" 2>/dev/null || unformatted+=("$file")
done
long=$(grep -nHE '^.{101,}$' "${files[@]}")
if ((${#unformatted[@]} > 0)); then
  printf 'not formatted:%s\n' ""
  printf '  %s\n' "${unformatted[@]}"
  echo "tests/format_test.sh --fix mends it"
fi
[[ -n $long ]] && printf 'longer than 100 columns:\n%s\n' "$long"
((${#unformatted[@]} == 0)) && [[ -z $long ]]
