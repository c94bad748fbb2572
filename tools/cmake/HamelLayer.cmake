# One function per kind of library target.

# A static library keeps its own copies of inline functions, whatever flags a program is compiled with
# (tools/cmake/localise): with GNU ld on ELF, and neither under sanitizers nor with objects of an LTO compiler.
string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
find_program(HAMEL_LD NAMES ld.bfd)
set(HAMEL_LOCALISE ON)
if(NOT HAMEL_LD OR NOT CMAKE_NM OR NOT CMAKE_OBJCOPY OR NOT CMAKE_EXECUTABLE_FORMAT STREQUAL "ELF"
   OR HAMEL_SANITIZE OR CMAKE_INTERPROCEDURAL_OPTIMIZATION
   OR "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${build_type}}" MATCHES "-flto|-fsanitize")
  set(HAMEL_LOCALISE OFF)
  message(STATUS "hamel: programs need the flags that the library is compiled with")
endif()
function(hamel_localise target)
  if(HAMEL_LOCALISE)
    # Unique symbols, of static variables in inline functions, cannot be made local: weak ones can.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fno-gnu-unique>)
    add_custom_command(TARGET ${target} POST_BUILD
      COMMAND ${PROJECT_SOURCE_DIR}/tools/cmake/localise ${CMAKE_AR} ${HAMEL_LD} ${CMAKE_NM}
              ${CMAKE_OBJCOPY} $<TARGET_FILE:${target}>)
  endif()
endfunction()

# Code that may become part of a shared library, such as the Python module (tools/python). Hidden symbols: calls
# between objects stay direct.
set(HAMEL_SHARED_CODE CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
if(NOT EMSCRIPTEN)
  list(APPEND HAMEL_SHARED_CODE POSITION_INDEPENDENT_CODE ON)
endif()

# Eigen and the standard library, parsed once for all sources of the layers: half of the time to compile most of them. No
# header of this project: an include against the arrows would go unseen. -fpch-preprocess lets ccache see through it.
if(HAMEL_PCH)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/pch.cpp CONTENT "")
  add_library(hamel_pch OBJECT EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/generated/pch.cpp)
  target_compile_options(hamel_pch PRIVATE $<$<CONFIG:Release>:-O2>
    $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>
    $<$<AND:$<BOOL:${HAMEL_LOCALISE}>,$<CXX_COMPILER_ID:GNU>>:-fno-gnu-unique>)
  target_compile_features(hamel_pch PRIVATE cxx_std_20)
  set_target_properties(hamel_pch PROPERTIES CXX_EXTENSIONS OFF ${HAMEL_SHARED_CODE})
  if(CMAKE_CXX_COMPILER_LAUNCHER)
    set_target_properties(hamel_pch PROPERTIES
      CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND};-E;env;CCACHE_DEPEND=1;${CMAKE_CXX_COMPILER_LAUNCHER}")
  endif()
  target_precompile_headers(hamel_pch PRIVATE
    <Eigen/Core> <Eigen/Geometry> <Eigen/LU>
    <algorithm> <array> <cmath> <functional> <limits> <map> <memory> <optional> <set> <span> <sstream>
    <string> <utility> <vector>)
endif()

# A layer is a folder, a library named after its last part and an include root of its own.
#
#   hamel_layer(groups
#     LINK hamel::lie                # seen by the layer's headers and by whoever links it
#     LINK_PRIVATE fmt::fmt          # used by the sources only
#     LINK_HEADERS_PRIVATE x::x      # header-only and used by the sources only: users never need it
#     HEADERS so3.hpp ...            # public: installed, and each compiled alone
#     SOURCES ...                    # neither SOURCES nor KERNELS: a header-only layer
#     KERNELS ...)                   # sources of what a step calls, compiled with -O3 and without errno
#
# build/include/groups/hamel/groups links to the folder, so that groups/so3.hpp is
# <hamel/groups/so3.hpp>, and a layer that does not link this one cannot include it.
function(hamel_layer path)
  cmake_path(GET path FILENAME layer)
  cmake_path(GET path PARENT_PATH parent)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" ""
                        "LINK;LINK_PRIVATE;LINK_HEADERS_PRIVATE;HEADERS;SOURCES;KERNELS")
  set(target hamel_${layer})
  set(root ${PROJECT_BINARY_DIR}/include/${layer})
  if(IS_SYMLINK ${root}/hamel/${parent})  # of a build folder from before the layer was split
    file(REMOVE ${root}/hamel/${parent})
  endif()
  file(MAKE_DIRECTORY ${root}/hamel/${parent})
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${path} ${root}/hamel/${path} SYMBOLIC)
  foreach(list SOURCES KERNELS)
    list(TRANSFORM arg_${list} PREPEND ${PROJECT_SOURCE_DIR}/${path}/ REGEX "^[^/]")
  endforeach()

  if(arg_SOURCES OR arg_KERNELS)
    add_library(${target} STATIC ${arg_SOURCES} ${arg_KERNELS})
    set(public PUBLIC)
    list(TRANSFORM arg_LINK_HEADERS_PRIVATE REPLACE "(.+)" "$<BUILD_INTERFACE:\\1>")
    target_link_libraries(${target} PRIVATE
      ${arg_LINK_PRIVATE} ${arg_LINK_HEADERS_PRIVATE} $<BUILD_INTERFACE:hamel_build_options>)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O2>)
    # Nobody reads errno: a root is one instruction, with the same bits.
    set_source_files_properties(${arg_KERNELS} PROPERTIES
      COMPILE_OPTIONS "$<$<CONFIG:Release>:-O3>;-fno-math-errno")
    set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF ${HAMEL_SHARED_CODE})
    # Small sources share headers: parsed once for eight of them. Not io, where GCC 12 then warns of strings that are not;
    # nor kernels, each of which takes its own time.
    if(NOT path STREQUAL "framework/io" AND NOT path STREQUAL "solvers")
      set_target_properties(${target} PROPERTIES UNITY_BUILD ${HAMEL_UNITY} UNITY_BUILD_BATCH_SIZE 8)
      set_source_files_properties(${arg_KERNELS} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
    hamel_localise(${target})
    if(TARGET hamel_pch)
      target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
      target_precompile_headers(${target} REUSE_FROM hamel_pch)
      # Functions of a precompiled header keep its -O2: a step took up to 60 % more instructions.
      set_source_files_properties(${arg_KERNELS} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
    endif()
  else()
    add_library(${target} INTERFACE)
    set(public INTERFACE)
  endif()
  add_library(hamel::${layer} ALIAS ${target})
  list(TRANSFORM arg_HEADERS PREPEND ${root}/hamel/${path}/)
  target_sources(${target} ${public} FILE_SET HEADERS BASE_DIRS ${root} FILES ${arg_HEADERS})
  target_compile_features(${target} ${public} cxx_std_20)
  target_link_libraries(${target} ${public} ${arg_LINK})
  set_target_properties(${target} PROPERTIES
    EXPORT_NAME ${layer} VERIFY_INTERFACE_HEADER_SETS ON)
endfunction()

# hamel::hamel links every layer and brings <hamel/hamel.hpp> and <hamel/simulate.hpp>, the headers outside a layer.
function(hamel_umbrella)
  list(TRANSFORM HAMEL_ROOMS PREPEND hamel:: OUTPUT_VARIABLE rooms)
  set(root ${PROJECT_BINARY_DIR}/include/umbrella)
  set(headers ${ARGN})
  foreach(header ${ARGN})  # no link: it is installed
    cmake_path(GET header FILENAME name)
    configure_file(${PROJECT_SOURCE_DIR}/${header} ${root}/hamel/${name} COPYONLY)
  endforeach()
  list(TRANSFORM headers REPLACE "^.*/" "${root}/hamel/")
  add_library(hamel_umbrella INTERFACE)
  add_library(hamel::hamel ALIAS hamel_umbrella)
  target_sources(hamel_umbrella INTERFACE
    FILE_SET HEADERS BASE_DIRS ${root} FILES ${headers})
  target_link_libraries(hamel_umbrella
    INTERFACE hamel::systems hamel::solvers hamel::groups ${rooms})
  set_target_properties(hamel_umbrella PROPERTIES
    EXPORT_NAME hamel VERIFY_INTERFACE_HEADER_SETS ON)
endfunction()
