# Debian packages, one for each component of the installation: `cpack -G DEB` in the build folder. `./run package`
# makes all of them.
set(CPACK_PACKAGE_CONTACT "The Touchstone authors")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)

# touchstone_debian_package(NAME SECTION DESCRIPTION [DEPENDS|RECOMMENDS PACKAGES]…)
function(touchstone_debian_package name section description)
  cmake_parse_arguments(PACKAGE "" "DEPENDS;RECOMMENDS" "" ${ARGN})
  string(TOUPPER ${name} component)
  set(CPACK_DEBIAN_${component}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${component}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(CPACK_DEBIAN_${component}_DESCRIPTION ${description} PARENT_SCOPE)
  set(CPACK_DEBIAN_${component}_PACKAGE_DEPENDS "${PACKAGE_DEPENDS}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${component}_PACKAGE_RECOMMENDS "${PACKAGE_RECOMMENDS}" PARENT_SCOPE)
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/${name} RENAME copyright
    COMPONENT ${name})
endfunction()

set(tbb)
if(TOUCHSTONE_HAS_TBB)
  set(tbb ", libtbb-dev (>= 2021)")
endif()
touchstone_debian_package(libtouchstone-dev libdevel
  "Certified continuous collision detection: libraries in C++ and C"
  DEPENDS "libeigen3-dev (>= 3.4)${tbb}"
  RECOMMENDS "libgmp-dev, libmpfr-dev, libfmt-dev (>= 9), gappa")
if(TOUCHSTONE_BUILD_EXACT)
  touchstone_debian_package(touchstone-check math "Checker of the certificates of continuous collision detection")
endif()
if(TOUCHSTONE_BUILD_TOOL)
  touchstone_debian_package(touchstone math "Tests solvers of continuous collision detection against exact ground truth"
    RECOMMENDS "touchstone-check")
endif()
include(CPack)
