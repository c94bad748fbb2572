# libhamel.so.<major>: the door by name (<hamel/simulate.hpp>) as a shared library, hamel::shared, beside the archives and of
# their objects. What carries HAMEL_API (framework/io/export.hpp) is visible, all else hidden. A program that links it needs
# no package of the archives, and takes a new version without being linked again.
include(GNUInstallDirs)

set(layers ${HAMEL_ROOMS} groups mechanisms solvers systems)
set(archives "")
set(roots ${PROJECT_BINARY_DIR}/include/umbrella)
foreach(layer IN LISTS layers)
  get_target_property(type hamel_${layer} TYPE)
  list(APPEND roots ${PROJECT_BINARY_DIR}/include/${layer})
  if(type STREQUAL "STATIC_LIBRARY")
    list(APPEND archives $<TARGET_FILE:hamel_${layer}>)
  endif()
endforeach()

set(version_script ${PROJECT_SOURCE_DIR}/tools/cmake/libhamel.map)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/shared.cpp CONTENT "")
add_library(hamel_shared SHARED ${PROJECT_BINARY_DIR}/generated/shared.cpp)
add_library(hamel::shared ALIAS hamel_shared)
target_link_options(hamel_shared PRIVATE
  LINKER:--whole-archive ${archives} LINKER:--no-whole-archive
  LINKER:--version-script=${version_script} LINKER:--no-undefined LINKER:--as-needed LINKER:-O1)
target_link_libraries(hamel_shared PRIVATE $<BUILD_INTERFACE:hamel::hamel>)
target_compile_features(hamel_shared INTERFACE cxx_std_20)
target_include_directories(hamel_shared INTERFACE
  "$<BUILD_INTERFACE:${roots}>" $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
hamel_opens_modules(hamel_shared)
set_target_properties(hamel_shared PROPERTIES
  OUTPUT_NAME hamel EXPORT_NAME shared CXX_EXTENSIONS OFF LINK_DEPENDS ${version_script}
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR})
