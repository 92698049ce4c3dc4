# touchstone::gmp, touchstone::gmpxx and touchstone::mpfr: GMP and MPFR have no packages of CMake's, and stand where
# the compiler does not look in vcpkg, Conan and Homebrew. Installed, for users of exact and derivation.
function(touchstone_find_library name header)
  if(TARGET touchstone::${name})
    return()
  endif()
  find_path(TOUCHSTONE_${name}_INCLUDE ${header} REQUIRED)
  find_library(TOUCHSTONE_${name}_LIBRARY ${name} REQUIRED)
  mark_as_advanced(TOUCHSTONE_${name}_INCLUDE TOUCHSTONE_${name}_LIBRARY)
  add_library(touchstone::${name} INTERFACE IMPORTED GLOBAL)
  target_include_directories(touchstone::${name} INTERFACE ${TOUCHSTONE_${name}_INCLUDE})
  target_link_libraries(touchstone::${name} INTERFACE ${TOUCHSTONE_${name}_LIBRARY} ${ARGN})
endfunction()

touchstone_find_library(gmp gmp.h)
touchstone_find_library(gmpxx gmpxx.h touchstone::gmp)
touchstone_find_library(mpfr mpfr.h touchstone::gmp)
