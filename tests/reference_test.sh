#!/usr/bin/env bash
# The API reference builds without warnings, and has what callers need.
set -eu
command -v doxygen > /dev/null || { echo "no API reference: there is no doxygen (Debian: doxygen)"; exit 77; }
doxygen "$BARCHAN_BUILD/docs/Doxyfile"
for page in classbarchan_1_1Simulation classbarchan_1_1WallControl classbarchan_1_1ParticleView barchan_8h; do
  [[ -s $BARCHAN_BUILD/docs/html/$page.html ]] || { echo "the API reference lacks $page"; exit 1; }
done
grep -q 'shorter one where one is needed' "$BARCHAN_BUILD/docs/html/classbarchan_1_1Simulation.html" ||
  { echo "the API reference lacks comments"; exit 1; }
