# An overlay port of this clone: vcpkg install hamel --overlay-ports=tools/packages/vcpkg
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)

vcpkg_check_features(OUT_FEATURE_OPTIONS features
  FEATURES tools HAMEL_BUILD_TOOLS ceres HAMEL_CERES nlopt HAMEL_NLOPT hdf5 HAMEL_HDF5)
vcpkg_cmake_configure(
  SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS ${features} -DHAMEL_BUILD_TESTS=OFF -DHAMEL_BUILD_BENCHMARKS=OFF -DHAMEL_PYTHON=OFF -DHAMEL_URDFDOM=OFF -DHAMEL_LANES=OFF -DHAMEL_REPORT_PAGE=AUTO)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/hamel)
vcpkg_fixup_pkgconfig()
if("tools" IN_LIST FEATURES)
  vcpkg_copy_tools(TOOL_NAMES hamel AUTO_CLEAN)
endif()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
