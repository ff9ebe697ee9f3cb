# `cpack -G DEB` in the build folder makes a package for the Debian that it is built on; packaging/README.md.
set(CPACK_PACKAGE_NAME barchan)
set(CPACK_PACKAGE_CONTACT "the barchan authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "discrete element method on MPI one-sided communication and oneTBB")
set(CPACK_PACKAGE_DESCRIPTION
  "Library and command for disks and spheres that touch, bond and break, with the same bits on any number
of ranks, and with tools for experiments on hiding communication: sweeps, comparisons, pages for a
browser, and a lab of emulated hosts.")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_GENERATOR DEB)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Beside the libraries: what starts ranks; what the lab runs on; what a program that embeds the library is built with.
set(CPACK_DEBIAN_PACKAGE_DEPENDS openmpi-bin)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3, iproute2, util-linux")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS
  "g++, cmake, pkg-config, libopenmpi-dev, libtbb-dev, libeigen3-dev, libtomlplusplus-dev, libfmt-dev, libxxhash-dev, libpng-dev, zlib1g-dev")
include(CPack)
