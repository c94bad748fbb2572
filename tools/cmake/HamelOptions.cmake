# Options of the build, and the flags of our own targets. A user of the library sees none of them: they travel
# through the private interface target hamel_build_options.

option(HAMEL_BUILD_TOOLS "Build the program `hamel`" ${PROJECT_IS_TOP_LEVEL})
option(HAMEL_BUILD_TESTS "Build the tests and examples" ${PROJECT_IS_TOP_LEVEL})
option(HAMEL_BUILD_BENCHMARKS "Build the benchmarks" ${PROJECT_IS_TOP_LEVEL})
option(HAMEL_SHARED "Link libhamel.so, the library by name, beside the archives: for packages" OFF)
option(HAMEL_MODULES "The program, libhamel.so and the Python module open Ceres, NLopt and HDF5 when they are named"
       ${PROJECT_IS_TOP_LEVEL})
option(HAMEL_INSTALL "Define the install rules" ${PROJECT_IS_TOP_LEVEL})
option(HAMEL_WERROR "Treat warnings in our own sources as errors" ${PROJECT_IS_TOP_LEVEL})
option(HAMEL_PCH "Parse Eigen and the standard library once for all layers" ${PROJECT_IS_TOP_LEVEL})
option(HAMEL_UNITY "Compile sources but kernels eight at a time: half the processor time of a whole build" ON)
option(HAMEL_SANITIZE "Build with AddressSanitizer and UndefinedBehaviorSanitizer; with clang, the fuzz targets too" OFF)
set(page OFF)  # a part of another project fetches nothing
if(PROJECT_IS_TOP_LEVEL)
  set(page AUTO)
endif()
set(HAMEL_REPORT_PAGE ${page} CACHE STRING
    "The report page needs node and npm: ON fails without them, AUTO builds without it, OFF never")
set_property(CACHE HAMEL_REPORT_PAGE PROPERTY STRINGS AUTO ON OFF)
set(HAMEL_PYTHON AUTO CACHE STRING
    "The Python package needs build/venv (tools/setup --python): ON fails without, AUTO builds without it, OFF never")
set_property(CACHE HAMEL_PYTHON PROPERTY STRINGS AUTO ON OFF)
set(HAMEL_HDF5 AUTO CACHE STRING
    "Runs and studies also write HDF5 (libhdf5-dev): ON fails without it, AUTO builds without it")
set_property(CACHE HAMEL_HDF5 PROPERTY STRINGS AUTO ON OFF)
if(HAMEL_HDF5 STREQUAL "OFF")
  unset(HAMEL_HDF5_LIBRARY CACHE)
else()  # CMake's FindHDF5 needs a C compiler, which this project does not
  find_path(HAMEL_HDF5_INCLUDE hdf5.h PATH_SUFFIXES hdf5/serial)
  find_library(HAMEL_HDF5_LIBRARY NAMES hdf5 hdf5_serial)
  if(NOT HAMEL_HDF5_INCLUDE OR NOT HAMEL_HDF5_LIBRARY)
    if(HAMEL_HDF5 STREQUAL "ON")
      message(FATAL_ERROR "HAMEL_HDF5 is ON, but HDF5 was not found: install libhdf5-dev")
    endif()
    unset(HAMEL_HDF5_LIBRARY CACHE)
    message(STATUS "hamel: runs and studies write no HDF5 (libhdf5-dev is missing)")
  endif()
endif()
# Headers alone; its CMake target would link a library that Debian leaves out.
set(HAMEL_LANES AUTO CACHE STRING
    "Ensembles take several members at once (libxsimd-dev): ON fails without it, AUTO builds without, OFF never")
set_property(CACHE HAMEL_LANES PROPERTY STRINGS AUTO ON OFF)
set(HAMEL_HAS_XSIMD OFF)
if(NOT HAMEL_LANES STREQUAL "OFF")
  find_path(HAMEL_XSIMD_INCLUDE xsimd/xsimd.hpp)
  if(HAMEL_XSIMD_INCLUDE AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    set(HAMEL_HAS_XSIMD ON)
  elseif(HAMEL_LANES STREQUAL "ON")
    message(FATAL_ERROR "HAMEL_LANES is ON, but xsimd was not found, or this is no x86-64: install libxsimd-dev")
  else()
    message(STATUS "hamel: no lanes (libxsimd-dev is missing)")
  endif()
endif()
# True of a library that is linked at run time, such as the Python module: Debian's archives cannot be part of it.
set(HAMEL_OF_SHARED "$<OR:$<STREQUAL:$<TARGET_PROPERTY:TYPE>,MODULE_LIBRARY>,$<STREQUAL:$<TARGET_PROPERTY:TYPE>,SHARED_LIBRARY>>")

# For programs that link HDF5: the archive, where it links. Debian's shared library brings curl and with it 30 libraries.
if(HAMEL_HDF5_LIBRARY)
  find_library(HAMEL_HDF5_ARCHIVE NAMES libhdf5.a libhdf5_serial.a)
  find_library(HAMEL_SZ_LIBRARY NAMES sz)
  mark_as_advanced(HAMEL_HDF5_ARCHIVE HAMEL_SZ_LIBRARY)
  set(HAMEL_HDF5_LINK ${HAMEL_HDF5_LIBRARY})
  if(HAMEL_HDF5_ARCHIVE AND HAMEL_SZ_LIBRARY)
    include(CheckCXXSourceCompiles)
    set(archive ${HAMEL_HDF5_ARCHIVE} ${HAMEL_SZ_LIBRARY} z ${CMAKE_DL_LIBS} m)
    set(CMAKE_REQUIRED_INCLUDES ${HAMEL_HDF5_INCLUDE})
    set(CMAKE_REQUIRED_LIBRARIES ${archive})
    check_cxx_source_compiles("#include <hdf5.h>\nint main() { return H5open(); }" HAMEL_HDF5_ARCHIVE_LINKS)
    unset(CMAKE_REQUIRED_INCLUDES)
    unset(CMAKE_REQUIRED_LIBRARIES)
    if(HAMEL_HDF5_ARCHIVE_LINKS)
      list(REMOVE_AT archive 0)
      set(HAMEL_HDF5_LINK
          $<IF:${HAMEL_OF_SHARED},${HAMEL_HDF5_LIBRARY},${HAMEL_HDF5_ARCHIVE}> ${archive})
    endif()
  endif()
endif()

foreach(package "CERES;Solvers of Ceres" "NLOPT;Solvers of NLopt" "URDFDOM;Robots in URDF (liburdfdom-dev)")
  list(GET package 1 what)
  list(GET package 0 package)
  set(HAMEL_${package} AUTO CACHE STRING
      "${what}: ON fails without the package, AUTO builds without it, OFF never")
  set_property(CACHE HAMEL_${package} PROPERTY STRINGS AUTO ON OFF)
endforeach()

# hamel_find_optional(CERES Ceres): HAMEL_HAS_CERES, by HAMEL_CERES and what is installed.
function(hamel_find_optional package name)
  set(found FALSE)
  if(NOT HAMEL_${package} STREQUAL "OFF")
    set(required)
    if(HAMEL_${package} STREQUAL "ON")
      set(required REQUIRED)
    endif()
    find_package(${name} ${required} QUIET GLOBAL)
    set(found ${${name}_FOUND})
    if(NOT found)
      message(STATUS "hamel: no ${name}: what needs it is left out")
    endif()
  endif()
  set(HAMEL_HAS_${package} ${found} PARENT_SCOPE)
endfunction()

if(PROJECT_IS_TOP_LEVEL)
  if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Debug, Release, RelWithDebInfo or MinSizeRel" FORCE)
  endif()
  set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

  # A second build of the same sources, in any folder, takes seconds. The sloppiness is needed by ccache with
  # precompiled headers.
  find_program(CCACHE_PROGRAM ccache)
  if(CCACHE_PROGRAM AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER
        ${CMAKE_COMMAND} -E env
        CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
        CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
        ${CCACHE_PROGRAM})
  endif()
endif()

add_library(hamel_build_options INTERFACE)
target_compile_options(hamel_build_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wextra-semi
  -Wdouble-promotion -Wcast-qual -Wmissing-declarations
  $<$<BOOL:${HAMEL_WERROR}>:-Werror>)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(hamel_build_options INTERFACE
    -Wno-restrict)  # false alarms on "literal" + std::string, GCC bug 105651
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # templates: collecting the garbage is a seventh of the time
  target_compile_options(hamel_build_options INTERFACE --param=ggc-min-heapsize=1000000)
endif()
if(HAMEL_SANITIZE)
  # The four checks left out cost minutes of compilation on Eigen code (62 s a unit against 11 s).
  set(sanitizers -fsanitize=address,undefined -fno-sanitize=null,alignment,vptr,object-size
                 -fno-sanitize-recover=all -fno-omit-frame-pointer)
  # Tests are not optimised: what they call of the library, compiled there, is. (clang: 40 -> 21 s a unit)
  set(CMAKE_CXX_FLAGS_DEBUG "-g1")
  target_compile_options(hamel_build_options INTERFACE ${sanitizers}
    $<IF:$<BOOL:$<TARGET_PROPERTY:HAMEL_IS_TEST>>,-O0,-O1>
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)  # the GCC manual: false with -fsanitize
  target_link_options(hamel_build_options INTERFACE ${sanitizers})
  # clang's libFuzzer (tests/fuzz/run) needs to see the branches of the library.
  set(HAMEL_FUZZERS OFF)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    set(HAMEL_FUZZERS ON)
    target_compile_options(hamel_build_options INTERFACE
      -fno-sanitize=pointer-overflow  # Eigen's blocks of empty matrices
      $<$<NOT:$<BOOL:$<TARGET_PROPERTY:HAMEL_IS_TEST>>>:-fsanitize=fuzzer-no-link>)
  endif()
  find_program(HAMEL_LLD ld.lld)  # GNU ld: 3 s a test
  if(HAMEL_LLD)
    target_link_options(hamel_build_options INTERFACE -fuse-ld=lld)
  endif()
endif()
