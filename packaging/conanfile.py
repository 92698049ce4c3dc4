"""A recipe for Conan 2: conan create packaging --build=missing (-o "&:exact=True" for the oracle)."""

import os
import re

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load

folders = ["cmake", "exact", "fast", "filters", "tests/portability"]


class Touchstone(ConanFile):
    name = "touchstone"
    description = "Exact ground truth, verified solvers and test tools for continuous collision detection"
    license = "MIT"
    package_type = "static-library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"tbb": [True, False], "exact": [True, False]}
    default_options = {"tbb": True, "exact": False}

    @property
    def _root(self):
        return os.path.join(self.recipe_folder, os.pardir)

    def set_version(self):
        text = load(self, os.path.join(self._root, "CMakeLists.txt"))
        self.version = re.search(r"project\(touchstone VERSION ([0-9.]+)", text).group(1)

    def export_sources(self):
        copy(self, "CMakeLists.txt", self._root, self.export_sources_folder)
        copy(self, "LICENSE", self._root, self.export_sources_folder)
        for folder in folders:
            copy(self, f"{folder}/*", self._root, self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def validate(self):
        check_min_cppstd(self, 20)

    def requirements(self):
        self.requires("eigen/3.4.0", transitive_headers=True)
        if self.options.tbb:
            self.requires("onetbb/2021.12.0")
        if self.options.exact:
            self.requires("cgal/5.6.1")
            self.requires("gmp/6.3.0", transitive_headers=True)
            self.requires("mpfr/4.2.1")

    def generate(self):
        toolchain = CMakeToolchain(self)
        for name in ["ADAPTERS", "DERIVATION", "TESTS", "TOOL"]:
            toolchain.cache_variables[f"TOUCHSTONE_BUILD_{name}"] = False
        toolchain.cache_variables["TOUCHSTONE_BUILD_EXACT"] = bool(self.options.exact)
        toolchain.cache_variables["TOUCHSTONE_TBB"] = bool(self.options.tbb)
        toolchain.cache_variables["TOUCHSTONE_WERROR"] = False
        toolchain.cache_variables["TOUCHSTONE_CCACHE"] = False
        if self.options.exact:
            # CGAL's own package says so; the one of Conan does not.
            toolchain.preprocessor_definitions["CGAL_USE_GMPXX"] = "1"
        toolchain.generate()
        CMakeDeps(self).generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))

    def package_info(self):
        # The package has a touchstone-config.cmake of its own.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs.append(os.path.join("lib", "cmake", "touchstone"))
