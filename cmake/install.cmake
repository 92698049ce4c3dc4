# find_package(touchstone COMPONENTS fast) for simulators, exact for researchers, derivation for authors of filters;
# each component requires only its own packages.
include(CMakePackageConfigHelpers)

configure_package_config_file(cmake/touchstone-config.cmake.in touchstone-config.cmake
  INSTALL_DESTINATION ${touchstone_config_folder})
write_basic_package_version_file(touchstone-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/touchstone-config.cmake
              ${PROJECT_BINARY_DIR}/touchstone-config-version.cmake
        DESTINATION ${touchstone_config_folder})
