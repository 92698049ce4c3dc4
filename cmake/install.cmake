# find_package(touchstone COMPONENTS fast) for simulators, exact for researchers, scene_certificates for both, derivation for authors of filters;
# each component requires only its own packages.
include(CMakePackageConfigHelpers)

configure_package_config_file(cmake/touchstone-config.cmake.in touchstone-config.cmake
  INSTALL_DESTINATION ${touchstone_config_folder})
write_basic_package_version_file(touchstone-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/touchstone-config.cmake
              ${PROJECT_BINARY_DIR}/touchstone-config-version.cmake
              cmake/gmp.cmake
        DESTINATION ${touchstone_config_folder})

get_property(installed GLOBAL PROPERTY touchstone_installed)
file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/is_built-$<CONFIG>.cmake CONTENT
"set(installed \"${installed}\")\nset(build \"${PROJECT_BINARY_DIR}\")\ninclude(\"${PROJECT_SOURCE_DIR}/cmake/is_built.cmake\")\n")

# touchstone_pkg_config(NAME DESCRIPTION REQUIRED_PACKAGE…): touchstone-NAME.pc, for builds that use pkg-config. The
# libraries but touchstone_c are static, so what they need is linked with them.
file(RELATIVE_PATH touchstone_include_from_pc ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_FULL_INCLUDEDIR})
function(touchstone_pkg_config name description)
  list(JOIN ARGN ", " requires)
  configure_file(cmake/touchstone.pc.in touchstone-${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/touchstone-${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()
set(tbb)
if(TOUCHSTONE_HAS_TBB)
  set(tbb tbb)
endif()
touchstone_pkg_config(fast "Certified continuous collision detection" "eigen3 >= 3.4" ${tbb})
if(TOUCHSTONE_BUILD_EXACT)
  touchstone_pkg_config(exact "Exact continuous collision detection, with certificates" "eigen3 >= 3.4" gmpxx)
endif()
if(TOUCHSTONE_BUILD_ADAPTERS)
  touchstone_pkg_config(c "Certified continuous collision detection in C")
  # A linker of C adds neither.
  set(runtime ${CMAKE_CXX_IMPLICIT_LINK_LIBRARIES})
  list(FILTER runtime INCLUDE REGEX "^(std)?c[+][+]$|^m$")
  list(JOIN runtime " -l" runtime)
  set(more " -ltouchstone_fast -l${runtime}")
  touchstone_pkg_config(c_static "Certified continuous collision detection in C, as a static library" ${tbb})
endif()
