# An overlay port of the checkout that it stands in: vcpkg install touchstone --overlay-ports=packaging
get_filename_component(SOURCE_PATH ${CURRENT_PORT_DIR}/.. ABSOLUTE)

vcpkg_check_linkage(ONLY_STATIC_LIBRARY)
vcpkg_check_features(OUT_FEATURE_OPTIONS features FEATURES
  tbb TOUCHSTONE_TBB
  exact TOUCHSTONE_BUILD_EXACT
  tool TOUCHSTONE_BUILD_DERIVATION
  tool TOUCHSTONE_BUILD_TOOL)
vcpkg_cmake_configure(SOURCE_PATH ${SOURCE_PATH} OPTIONS ${features}
  -DTOUCHSTONE_BUILD_ADAPTERS=OFF
  -DTOUCHSTONE_BUILD_TESTS=OFF
  -DTOUCHSTONE_WERROR=OFF
  -DTOUCHSTONE_CCACHE=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/touchstone)
vcpkg_fixup_pkgconfig()
if("exact" IN_LIST FEATURES)
  vcpkg_copy_tools(TOOL_NAMES touchstone-check AUTO_CLEAN)
endif()
if("tool" IN_LIST FEATURES)
  vcpkg_copy_tools(TOOL_NAMES touchstone AUTO_CLEAN)
endif()
file(REMOVE_RECURSE ${CURRENT_PACKAGES_DIR}/debug/include ${CURRENT_PACKAGES_DIR}/debug/share
  ${CURRENT_PACKAGES_DIR}/share/doc)
vcpkg_install_copyright(FILE_LIST ${SOURCE_PATH}/LICENSE)
