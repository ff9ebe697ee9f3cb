#!/usr/bin/env bash
# By hand, since looking for what every file depends on takes long: makes the Debian package, unpacks it, and uses what is in it.
#   BARCHAN_SOURCE=$PWD BARCHAN_BUILD=$PWD/build/release bash tests/install/package.sh, in a folder of its own
set -eu
[[ $PWD != "$BARCHAN_SOURCE" ]] || { echo "run this in a folder of its own"; exit 1; }
for tool in cpack dpkg-deb dpkg-shlibdeps file; do
  command -v "$tool" > /dev/null || { echo "there is no $tool"; exit 1; }
done
rm -rf made unpacked work
mkdir made work
cpack --config "$BARCHAN_BUILD/CPackConfig.cmake" -D CPACK_DEBIAN_COMPRESSION_TYPE=none -B "$PWD/made" > cpack.log || { cat cpack.log; exit 1; }
package=$(echo made/*.deb)
dpkg-deb -x "$package" unpacked
depends=$(dpkg-deb -f "$package" Depends)
for name in openmpi-bin libopenmpi3 libtbb12 libfmt libstdc++6; do
  [[ $depends == *"$name"* ]] || { echo "the package does not depend on $name: $depends"; exit 1; }
done
cd work
bin=../unpacked/usr/bin
"$bin/barchan" --version
"$bin/barchan" check ../unpacked/usr/share/barchan/examples/soil_duct.toml > check.txt
"$bin/barchan-netlab" --help > netlab.txt
cmp <("$bin/barchan" schema) ../unpacked/usr/share/barchan/deck.schema.json
gzip -cd ../unpacked/usr/share/man/man1/barchan-run.1.gz 2> /dev/null | grep -q exchange ||
  grep -q exchange ../unpacked/usr/share/man/man1/barchan-run.1
[[ -s ../unpacked/usr/share/bash-completion/completions/barchan ]]
"$bin/barchan" run ../unpacked/usr/share/barchan/examples/two_particles.toml --quiet --out two.out
"$bin/barchan" report two.out
python3 -c "compile(open('$BARCHAN_SOURCE/packaging/spack/package.py').read(), 'package.py', 'exec')"
