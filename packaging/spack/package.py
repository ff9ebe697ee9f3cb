# Copy into a repository of recipes: REPO/packages/barchan/package.py. `git` is where you have the sources.
from spack.package import *


class Barchan(CMakePackage):
    """Discrete element method for disks and spheres on MPI one-sided communication and oneTBB, with the same bits
    on any number of ranks, and with tools for experiments on hiding communication."""

    version("main", branch="main")

    variant("tests", default=False, description="Build the tests")

    depends_on("cxx", type="build")
    depends_on("cmake@3.24:", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("mpi")
    depends_on("tbb")
    depends_on("eigen@3.4:")
    depends_on("tomlplusplus")
    depends_on("cli11@2:", type="build")
    depends_on("nlohmann-json@3:", type="build")
    depends_on("fmt")
    depends_on("xxhash")
    depends_on("libpng")
    depends_on("zlib-api")
    depends_on("googletest", when="+tests", type="build")
    depends_on("python", type="run")  # the network lab

    def cmake_args(self):
        return [self.define_from_variant("BARCHAN_BUILD_TESTS", "tests"), self.define("BARCHAN_BUILD_BENCH", False)]
