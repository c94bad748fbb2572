# Initial cache of the build for WebAssembly: cmake -C tools/playground/preset.cmake -S . -B build/playground/wasm
# (tools/playground/build does it). The project's own CMake, with what a browser has none of left out.
set(CMAKE_TOOLCHAIN_FILE /usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake CACHE FILEPATH "")
set(CMAKE_PROJECT_TOP_LEVEL_INCLUDES ${CMAKE_CURRENT_LIST_DIR}/packages.cmake CACHE FILEPATH "")
set(CMAKE_BUILD_TYPE Release CACHE STRING "")
set(CMAKE_CXX_FLAGS "-fwasm-exceptions -DEIGEN_DONT_PARALLELIZE -include ${CMAKE_CURRENT_LIST_DIR}/module/cxx20.hpp"
    CACHE STRING "")
foreach(option BUILD_BENCHMARKS BUILD_TESTS CERES HDF5 INSTALL LANES MODULES NLOPT PCH PYTHON REPORT_PAGE URDFDOM WERROR)
  set(HAMEL_${option} OFF CACHE STRING "")
endforeach()
