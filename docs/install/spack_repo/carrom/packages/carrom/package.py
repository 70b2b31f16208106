# SPDX-License-Identifier: BSD-3-Clause
# A recipe for Spack 1.0 or newer. docs/how-to/cluster.md has the commands.

from spack_repo.builtin.build_systems.cmake import CMakePackage

from spack.package import *


class Carrom(CMakePackage):
    """Carrom simulates hard discs in a box with MPI and OpenMP. Its results have
    the same bits on any number of ranks and threads."""

    # Carrom has no public page and no archive yet, so homepage, url and checksum cannot be given:
    # `spack develop --path` gives it a checkout.

    license("BSD-3-Clause")

    version("0.3.0")

    variant("shared", default=False, description="Install libcarrom.so, not libcarrom.a")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("pkgconfig", type=("build", "run"))  # for find_package(Carrom), as tomlplusplus
    depends_on("cli11@2.1.2:", type="build")
    depends_on("nlohmann-json@3.11.2:", type="build")
    depends_on("random123@1.14.0:", type="build")
    depends_on("tomlplusplus@3.3.0:")

    depends_on("mpi@3:")
    depends_on("hdf5@1.10.8: +mpi")
    depends_on("fmt@9.1.0:")
    depends_on("highway@1.0.3:")
    depends_on("xxhash@0.8.1:")

    conflicts("%gcc@:11", msg="Carrom needs g++ 12 or newer")
    conflicts("%clang@:13", msg="Carrom needs clang 14 or newer")

    def cmake_args(self):
        return [
            self.define("CARROM_TESTS", False),
            self.define_from_variant("CARROM_SHARED", "shared"),
            self.define("RANDOM123_INCLUDE_DIR", self.spec["random123"].prefix.include),
        ]
