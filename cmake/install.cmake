# find_package(touchstone) for simulators (touchstone::fast) and researchers (touchstone::exact).
include(CMakePackageConfigHelpers)

set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/touchstone)
install(EXPORT touchstone NAMESPACE touchstone:: DESTINATION ${config_dir} FILE touchstone-targets.cmake)
configure_package_config_file(cmake/touchstone-config.cmake.in touchstone-config.cmake
  INSTALL_DESTINATION ${config_dir})
write_basic_package_version_file(touchstone-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/touchstone-config.cmake
              ${PROJECT_BINARY_DIR}/touchstone-config-version.cmake
        DESTINATION ${config_dir})
