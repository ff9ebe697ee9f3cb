#!/usr/bin/env bash
# Every header compiles alone, and sees no layer but its own and those below it.
# A header that its own source includes first has been compiled alone by the build, so it is passed over here.
# Arguments: compiler flags that name system include folders.
set -u
cd "$BARCHAN_SOURCE" || exit 1
export BARCHAN_FLAGS="-std=c++20 -fsyntax-only -Wall -Wextra -Werror $*"

check_header() {
  local header=$1 layer=${1%%/*} includes="" wide=""
  local -a layers=(core comm tasks app)
  if grep -m 1 '^#include' "${header%.hpp}.cpp" 2> /dev/null | grep -qF "<barchan/$header>"; then return 0; fi
  for below in "${layers[@]}"; do
    includes+=" -I$BARCHAN_BUILD/include/$below"
    [[ $below == "$layer" ]] && break
  done
  case $header in
    *avx512*) wide="-mavx512f -mavx512dq -mavx512vl -mavx512bw -mavx2 -mfma" ;;
    *avx2*) wide="-mavx2 -mfma" ;;
  esac
  if [[ -n $wide && $(uname -m) != x86_64 ]]; then return 0; fi
  # shellcheck disable=SC2086
  echo "#include <barchan/$header>" | "$CXX" $BARCHAN_FLAGS $wide $includes -x c++ - ||
    { echo "does not compile alone: $header"; return 1; }
}
export -f check_header

find core comm tasks app -name '*.hpp' -print0 |
  xargs -0 -r -n 1 -P "$(nproc)" bash -c 'check_header "$0"'
