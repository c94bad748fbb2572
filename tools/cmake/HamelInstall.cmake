# `cmake --install`: libraries, headers, the program, and the packages that find_package(hamel) and pkg-config find. `cpack`
# makes Debian packages of its components: dev, program, doc, lib with HAMEL_SHARED, and python where the package was built.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

list(TRANSFORM HAMEL_ROOMS PREPEND hamel_ OUTPUT_VARIABLE rooms)
set(libraries ${rooms} hamel_groups hamel_mechanisms hamel_solvers hamel_systems hamel_umbrella)
foreach(part io_hdf5 solvers_ceres solvers_nlopt)
  if(TARGET hamel_${part})
    list(APPEND libraries hamel_${part})
  endif()
endforeach()
if(HAMEL_HAS_XSIMD)
  list(APPEND libraries ${HAMEL_LANE_TARGETS})
endif()
install(TARGETS ${libraries} EXPORT hamelTargets COMPONENT dev FILE_SET HEADERS COMPONENT dev)
if(TARGET hamel_shared)
  install(TARGETS hamel_shared EXPORT hamelTargets LIBRARY COMPONENT lib NAMELINK_COMPONENT dev)
endif()
get_property(modules GLOBAL PROPERTY hamel_modules)
if(modules)
  install(TARGETS ${modules} LIBRARY DESTINATION ${HAMEL_MODULE_FOLDER} COMPONENT modules)
endif()
if(TARGET hamel_program)
  install(TARGETS hamel_program COMPONENT program)
  get_target_property(schemas hamel_schemas hamel_files)
  install(FILES ${schemas} DESTINATION ${CMAKE_INSTALL_DATADIR}/hamel/schema COMPONENT program)
  install(FILES ${PROJECT_BINARY_DIR}/playground/site/playground.html DESTINATION ${CMAKE_INSTALL_DATADIR}/hamel
          COMPONENT program OPTIONAL)  # of `hamel live`
  install(DIRECTORY ${PROJECT_BINARY_DIR}/tools/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1
          COMPONENT program OPTIONAL FILES_MATCHING PATTERN *.1.gz)
  set(completion ${PROJECT_SOURCE_DIR}/tools/packages/completion)
  install(PROGRAMS ${completion}/candidates DESTINATION ${CMAKE_INSTALL_DATADIR}/hamel COMPONENT program)
  install(FILES ${completion}/hamel.bash RENAME hamel
          DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program)
  install(FILES ${completion}/_hamel DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions COMPONENT program)
  install(FILES ${completion}/hamel.fish
          DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program)
endif()

# What `cmake --install` and cpack take, without tests.
add_custom_target(hamel_installed DEPENDS ${libraries} ${modules})
foreach(target hamel_shared hamel_program hamel_manual hamel_schemas hamel_python hamel_python_stub)
  if(TARGET ${target})
    add_dependencies(hamel_installed ${target})
  endif()
endforeach()

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/hamel)
install(EXPORT hamelTargets NAMESPACE hamel:: DESTINATION ${package_dir} COMPONENT dev)
configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/tools/cmake/hamelConfig.cmake.in ${PROJECT_BINARY_DIR}/hamelConfig.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(
  ${PROJECT_BINARY_DIR}/hamelConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/hamelConfig.cmake ${PROJECT_BINARY_DIR}/hamelConfigVersion.cmake
        DESTINATION ${package_dir} COMPONENT dev)

# pkg-config: the archives, which use one another, as a group; what they need as they were found.
set(archives "")
set(needed "")
foreach(library IN LISTS libraries)
  get_target_property(type ${library} TYPE)
  if(type STREQUAL "STATIC_LIBRARY")
    list(APPEND archives -l${library})
  endif()
endforeach()
if(HAMEL_HAS_NLOPT)
  list(APPEND needed -lnlopt)
endif()
if(HAMEL_HAS_CERES)
  list(APPEND needed -lceres -lglog)
endif()
if(HAMEL_HAS_URDFDOM)
  list(APPEND needed -lurdfdom_model -lconsole_bridge)
endif()
if(HAMEL_HDF5_ARCHIVE_LINKS)
  cmake_path(GET HAMEL_HDF5_ARCHIVE FILENAME archive)
  list(APPEND needed -l:${archive} -lsz -ldl -lm)
elseif(HAMEL_HDF5_LIBRARY)
  cmake_path(GET HAMEL_HDF5_LIBRARY FILENAME library)
  list(APPEND needed -l:${library})
endif()
list(JOIN archives " " archives)
list(JOIN needed " " needed)
set(HAMEL_PC_LIBS "-Wl,--start-group ${archives} -Wl,--end-group ${needed}")
get_target_property(HAMEL_PC_EIGEN Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
file(RELATIVE_PATH HAMEL_PC_PREFIX /p/${CMAKE_INSTALL_LIBDIR}/pkgconfig /p)
configure_file(${PROJECT_SOURCE_DIR}/tools/packages/hamel.pc.in ${PROJECT_BINARY_DIR}/hamel.pc @ONLY)
if(TARGET hamel_shared)
  configure_file(${PROJECT_SOURCE_DIR}/tools/packages/hamel-shared.pc.in ${PROJECT_BINARY_DIR}/hamel-shared.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/hamel-shared.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)
endif()
install(FILES ${PROJECT_BINARY_DIR}/hamel.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)

install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT doc)
# The commands, and the kinds of TOML files; folders as in the tree.
foreach(page tools/README.md systems/README.md systems/mechanisms/README.md systems/mechanisms/kick_scooter.toml)
  cmake_path(GET page PARENT_PATH folder)
  install(FILES ${PROJECT_SOURCE_DIR}/${page} DESTINATION ${CMAKE_INSTALL_DOCDIR}/${folder} COMPONENT doc)
endforeach()
# All examples: programs, systems by data, mechanisms, robots, in C++, TOML and Python.
foreach(folder tests/examples tools/python/examples)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder}/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/${folder} COMPONENT doc
          FILES_MATCHING PATTERN *.cpp PATTERN *.toml PATTERN *.csv PATTERN *.urdf PATTERN *.py)
endforeach()
# The site, where tools/docs/build has made it; only in the package, since it is no part of the build.
install(DIRECTORY ${PROJECT_BINARY_DIR}/docs/html DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT doc
        OPTIONAL EXCLUDE_FROM_ALL PATTERN .buildinfo EXCLUDE PATTERN .doctrees EXCLUDE)
if(TARGET hamel_python)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/tools/python/hamel DESTINATION lib/python3/dist-packages
          COMPONENT python EXCLUDE_FROM_ALL FILES_MATCHING PATTERN *.py PATTERN py.typed)
  install(TARGETS hamel_python DESTINATION lib/python3/dist-packages/hamel COMPONENT python EXCLUDE_FROM_ALL)
  install(FILES ${PROJECT_BINARY_DIR}/tools/python/hamel/_hamel.pyi
          DESTINATION lib/python3/dist-packages/hamel COMPONENT python EXCLUDE_FROM_ALL)
endif()

if(PROJECT_IS_TOP_LEVEL)
  include(HamelPackages)
endif()
