#!/usr/bin/env bash
# Two traps of wide kernels, looked for in the object code of the layers:
# - a fused multiply-add that the compiler made up: it rounds once where plain code rounds twice, and so changes the
#   bits. Those that a source asks for by an intrinsic are meant (with a factor of one or minus one they are exact);
# - an inline function shared with plain code, compiled into a *_avx2/_avx512 object: the linker keeps any one copy,
#   and the binary then dies on a machine without these instructions. Such objects may share none but their own.
set -u
cd "$BARCHAN_BUILD" || exit 1
[[ $(uname -m) == x86_64 ]] || exit 77
status=0

# _mm512_fmadd_pd -> vfmadd...pd
meant=$(grep -rhoE '_mm(256|512)?_(mask_|maskz_)?fn?m(add|sub|addsub|subadd)_(pd|sd)\b' "$BARCHAN_SOURCE"/{core,comm,tasks} |
  sed -E 's/.*_(f[a-z]+)_(pd|sd)$/v\1[0-9]+\2/' | sort -u | paste -sd '|')
mapfile -t libraries < <(find . -maxdepth 1 -name 'libbarchan_*.a')
for library in "${libraries[@]}"; do
  fused=$(objdump -d --no-show-raw-insn -C "$library" | awk -v meant="^(${meant:-none})$" '
    /^[0-9a-f]+ <.*>:$/ { name = $0; sub(/^[0-9a-f]+ /, "", name) }
    $2 ~ /^vfn?m(add|sub)/ && $2 !~ meant { print "  " name " " $2 }' | sort | uniq -c)
  if [[ -n $fused ]]; then
    printf 'fused multiply-adds in %s:\n%s\n' "$library" "$fused"
    status=1
  fi
done

mapfile -t wide_objects < <(find CMakeFiles/barchan_*.dir -name '*_avx2.cpp.o' -o -name '*_avx512.cpp.o')
for object in "${wide_objects[@]}"; do
  shared=$(nm -C --defined-only "$object" | sed -n 's/^[0-9a-f]* W //p' | grep -viE 'avx2|avx512')
  if [[ -n $shared ]]; then
    printf 'inline functions that %s shares with plain code:\n%s\n' "$object" "$shared"
    status=1
  fi
done
exit $status
