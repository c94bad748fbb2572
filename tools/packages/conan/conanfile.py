"""hamel for Conan 2: conan create tools/packages/conan --build=missing"""

import os
import re

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load


class Hamel(ConanFile):
    name = "hamel"
    description = "Geometric integrators for nonholonomic systems on Lie groups"
    license = "BSD-3-Clause"
    package_type = "static-library"
    settings = "os", "compiler", "build_type", "arch"
    options = {"with_hdf5": [True, False], "with_nlopt": [True, False], "with_ceres": [True, False]}
    default_options = {"with_hdf5": False, "with_nlopt": False, "with_ceres": False}

    @property
    def _clone(self):
        return os.path.join(self.recipe_folder, "..", "..", "..")

    def set_version(self):
        lists = load(self, os.path.join(self._clone, "CMakeLists.txt"))
        self.version = re.search(r"project\(hamel VERSION ([0-9.]+)", lists)[1]

    def export_sources(self):
        for pattern in ("CMakeLists.txt", "LICENSE", "README.md", "framework/*", "groups/*", "solvers/*", "systems/*", "tools/*",
                        "tests/examples/*"):
            copy(self, pattern, self._clone, self.export_sources_folder, excludes="tools/report/node_modules/*")

    def layout(self):
        cmake_layout(self)

    def requirements(self):
        self.requires("eigen/3.4.0", transitive_headers=True)
        self.requires("fmt/9.1.0")
        self.requires("tomlplusplus/3.3.0")
        self.requires("muparser/[>=2.3.3 <3]")
        self.requires("nlohmann_json/3.11.2")
        self.requires("zlib/[>=1.2.11 <2]")
        if self.options.with_hdf5:
            self.requires("hdf5/[>=1.10.8 <1.15]")
        if self.options.with_nlopt:
            self.requires("nlopt/2.7.1")
        if self.options.with_ceres:
            self.requires("ceres-solver/2.1.0")

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        for name in ("TOOLS", "TESTS", "BENCHMARKS"):
            toolchain.cache_variables[f"HAMEL_BUILD_{name}"] = "OFF"
        for name in ("URDFDOM", "LANES", "PYTHON"):
            toolchain.cache_variables[f"HAMEL_{name}"] = "OFF"
        for name in ("hdf5", "nlopt", "ceres"):
            toolchain.cache_variables[f"HAMEL_{name.upper()}"] = "ON" if self.options.get_safe(f"with_{name}") else "OFF"
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()

    def package_info(self):  # the package's own hamelConfig.cmake is what find_package(hamel) finds
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = [os.path.join("lib", "cmake", "hamel")]
