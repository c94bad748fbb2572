# Optional parts of the library: what needs a package that not everyone has.
#
# A part is a static library, which programs of users link. The program, libhamel.so and the Python module of the build open
# it as a module instead, hamel_<part>.so, when it is named (framework/io/module.hpp): Ceres alone brings 25 libraries and
# a thread for each core.
include(GNUInstallDirs)
if(NOT UNIX OR HAMEL_SANITIZE OR (PROJECT_IS_TOP_LEVEL AND NOT HAMEL_BUILD_TOOLS AND NOT HAMEL_SHARED))
  set(HAMEL_MODULES OFF)
endif()
set(HAMEL_MODULE_FOLDER ${CMAKE_INSTALL_LIBDIR}/hamel)  # in the build and installed

# hamel_part(ceres OF solvers LINK Ceres::ceres SOURCES ceres.cpp ... [SHARED library]): the target hamel_solvers_ceres, to be
# linked by ${HAMEL_PART_CERES}. SHARED: the shared library of the package, without which there is no module. Besides
# SOURCES, ceres_module.cpp has the entry of the module, and ceres_opened.cpp is linked in place of SOURCES.
function(hamel_part part)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "OF;FOLDER;SHARED" "LINK;SOURCES")
  if(arg_FOLDER)
    string(APPEND arg_FOLDER /)
  endif()
  list(TRANSFORM arg_SOURCES PREPEND "${arg_FOLDER}")
  set(target hamel_${arg_OF}_${part})
  hamel_part_library(${target} ${arg_OF} "${arg_LINK}" "${arg_SOURCES}")
  add_library(hamel::${arg_OF}_${part} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${arg_OF}_${part})
  set(link hamel::${arg_OF}_${part})
  if(HAMEL_MODULES AND arg_SHARED MATCHES "\\.(so|dylib)")
    hamel_part_library(${target}_opened ${arg_OF} fmt::fmt ${arg_FOLDER}${part}_opened.cpp)
    set(module hamel_module_${part})
    add_library(${module} MODULE ${arg_FOLDER}${part}_module.cpp)
    string(REPLACE . _ entry hamel_${part}_${PROJECT_VERSION})
    target_compile_definitions(${module} PRIVATE HAMEL_MODULE_ENTRY=${entry})
    target_link_libraries(${module} PRIVATE ${target} fmt::fmt hamel_build_options)
    set_target_properties(${module} PROPERTIES PREFIX "" SUFFIX .so OUTPUT_NAME hamel_${part} CXX_EXTENSIONS OFF
      LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/${HAMEL_MODULE_FOLDER} ${HAMEL_SHARED_CODE})
    if(NOT arg_OF STREQUAL "io")  # what the solvers link has HDF5
      set_target_properties(${module} PROPERTIES HAMEL_OPENS_MODULES ON)
    endif()
    if(LINUX)
      set(map ${PROJECT_SOURCE_DIR}/tools/cmake/module.map)
      target_link_options(${module} PRIVATE LINKER:--version-script=${map} LINKER:--as-needed)
      set_target_properties(${module} PROPERTIES LINK_DEPENDS ${map})
    endif()
    set_property(GLOBAL APPEND PROPERTY hamel_modules ${module})
    set(opens $<BOOL:$<TARGET_PROPERTY:HAMEL_OPENS_MODULES>>)
    set(link $<BUILD_INTERFACE:$<IF:${opens},${target}_opened,${target}>> $<INSTALL_INTERFACE:${link}>)
  endif()
  string(TOUPPER ${part} part)
  set(HAMEL_PART_${part} ${link} CACHE INTERNAL "how the part is linked")
endfunction()
function(hamel_part_library target of link sources)
  add_library(${target} STATIC ${sources})
  target_link_libraries(${target} PUBLIC hamel::${of} PRIVATE ${link} $<BUILD_INTERFACE:hamel_build_options>)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O2>)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF ${HAMEL_SHARED_CODE})
  hamel_localise(${target})
endfunction()

# hamel_opens_modules(<target>): of the build, and linked to the library.
function(hamel_opens_modules target)
  get_property(modules GLOBAL PROPERTY hamel_modules)
  if(modules)
    set_target_properties(${target} PROPERTIES HAMEL_OPENS_MODULES ON)
    add_dependencies(${target} ${modules})
  endif()
endfunction()
