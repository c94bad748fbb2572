# One function per kind of library target.

# A layer is a folder, a static library and an include root of its own.
#
#   hamel_layer(groups
#     LINK hamel::framework          # seen by the layer's headers and by whoever links it
#     LINK_PRIVATE fmt::fmt          # used by the sources only
#     LINK_HEADERS_PRIVATE x::x      # header-only and used by the sources only: users never need it
#     HEADERS so3.hpp ...            # public: installed, and each compiled alone
#     SOURCES so3.cpp ...
#     KERNELS loops.cpp ...)         # sources with the time loops, compiled with -O3
#
# build/include/groups/hamel/groups links to the folder, so that groups/so3.hpp is
# <hamel/groups/so3.hpp>, and a layer that does not link this one cannot include it.
function(hamel_layer layer)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" ""
                        "LINK;LINK_PRIVATE;LINK_HEADERS_PRIVATE;HEADERS;SOURCES;KERNELS")
  set(target hamel_${layer})
  set(root ${PROJECT_BINARY_DIR}/include/${layer})
  file(MAKE_DIRECTORY ${root}/hamel)
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${root}/hamel/${layer} SYMBOLIC)

  if(NOT arg_SOURCES AND NOT arg_KERNELS)
    file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/empty.cpp "")
    set(arg_SOURCES ${CMAKE_CURRENT_BINARY_DIR}/empty.cpp)
  endif()
  add_library(${target} STATIC ${arg_SOURCES} ${arg_KERNELS})
  add_library(hamel::${layer} ALIAS ${target})
  list(TRANSFORM arg_HEADERS PREPEND ${root}/hamel/${layer}/)
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS ${root} FILES ${arg_HEADERS})
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O2>)
  if(NOT HAMEL_SANITIZE)
    set_source_files_properties(${arg_KERNELS} PROPERTIES COMPILE_OPTIONS $<$<CONFIG:Release>:-O3>)
  endif()
  target_link_libraries(${target}
    PUBLIC ${arg_LINK}
    PRIVATE ${arg_LINK_PRIVATE} $<BUILD_INTERFACE:hamel_build_options>)
  foreach(library IN LISTS arg_LINK_HEADERS_PRIVATE)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:${library}>)
  endforeach()
  set_target_properties(${target} PROPERTIES
    CXX_EXTENSIONS OFF EXPORT_NAME ${layer} VERIFY_INTERFACE_HEADER_SETS ON)
endfunction()

# hamel::hamel links every layer and brings <hamel/hamel.hpp>, the one header outside a layer.
function(hamel_umbrella header)
  set(root ${PROJECT_BINARY_DIR}/include/umbrella)
  file(MAKE_DIRECTORY ${root}/hamel)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${header} ${root}/hamel/hamel.hpp SYMBOLIC)
  add_library(hamel_umbrella INTERFACE)
  add_library(hamel::hamel ALIAS hamel_umbrella)
  target_sources(hamel_umbrella INTERFACE
    FILE_SET HEADERS BASE_DIRS ${root} FILES ${root}/hamel/hamel.hpp)
  target_link_libraries(hamel_umbrella
    INTERFACE hamel::systems hamel::solvers hamel::groups hamel::framework)
  set_target_properties(hamel_umbrella PROPERTIES
    EXPORT_NAME hamel VERIFY_INTERFACE_HEADER_SETS ON)
endfunction()

# Keeps the files that exist: only while the tree is being written.
macro(hamel_existing out)
  set(${out})
  foreach(file ${ARGN})
    if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${file})
      list(APPEND ${out} ${file})
    endif()
  endforeach()
endmacro()
