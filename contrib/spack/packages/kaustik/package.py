"""Kaustik from its source: README.md."""
try:
    # From Spack 1.0 on.
    from spack_repo.builtin.build_systems.cmake import CMakePackage
except ImportError:
    pass
from spack.package import *


class Kaustik(CMakePackage):
    """Photon mapping renderer in physical units."""

    # The site's copy of the source; `spack dev-build` needs none.
    git = "file:///usr/local/src/kaustik"

    license("Apache-2.0")

    version("0.1.0", branch="main")

    depends_on("cxx", type="build")
    depends_on("cmake@3.22:", type="build")
    depends_on("ninja", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("python@3:", type="build")

    depends_on("embree@3.13:4")
    depends_on("tbb")
    depends_on("imath")
    depends_on("openexr@3:")
    depends_on("libtiff")
    depends_on("libpng")
    depends_on("jpeg")
    depends_on("libwebp")
    depends_on("highway")
    depends_on("pugixml")
    depends_on("zlib-api")
    depends_on("fmt")
    depends_on("cli11")
    depends_on("boost@1.75:")
    depends_on("nlohmann-json")

    generator("ninja")

    def cmake_args(self):
        return [
            self.define("KAUSTIK_TESTS", False),
            self.define("KAUSTIK_BENCHMARKS", False),
            self.define("KAUSTIK_UNITY", True),
            self.define("KAUSTIK_PRECOMPILED_HEADERS", True),
        ]
