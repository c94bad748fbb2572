# `cmake --install`: libraries, headers, the program, and the package that find_package(hamel) finds.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

list(TRANSFORM HAMEL_ROOMS PREPEND hamel_ OUTPUT_VARIABLE rooms)
install(TARGETS ${rooms} hamel_groups hamel_solvers hamel_systems hamel_umbrella
        EXPORT hamelTargets FILE_SET HEADERS)
foreach(package ceres nlopt)
  if(TARGET hamel_solvers_${package})
    install(TARGETS hamel_solvers_${package} EXPORT hamelTargets)
  endif()
endforeach()
if(TARGET hamel_program)
  install(TARGETS hamel_program)
  get_target_property(schemas hamel_schemas hamel_files)
  install(FILES ${schemas} DESTINATION ${CMAKE_INSTALL_DATADIR}/hamel/schema)
endif()

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/hamel)
install(EXPORT hamelTargets NAMESPACE hamel:: DESTINATION ${package_dir})
configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/tools/cmake/hamelConfig.cmake.in ${PROJECT_BINARY_DIR}/hamelConfig.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(
  ${PROJECT_BINARY_DIR}/hamelConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/hamelConfig.cmake ${PROJECT_BINARY_DIR}/hamelConfigVersion.cmake
        DESTINATION ${package_dir})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
# The commands, and the four kinds of TOML files with an example of a system by data; folders as in the tree.
foreach(page tools/README.md systems/README.md systems/mechanisms/README.md
        systems/mechanisms/kick_scooter.toml tests/examples/scooter_by_rows.toml
        tests/examples/skate_in_a_bowl.toml tests/examples/contact_oscillator.toml
        tests/examples/particle_in_potential.toml)
  cmake_path(GET page PARENT_PATH folder)
  install(FILES ${PROJECT_SOURCE_DIR}/${page} DESTINATION ${CMAKE_INSTALL_DOCDIR}/${folder})
endforeach()
