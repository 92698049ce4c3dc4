# The compilation of every target of the project.

set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

add_library(touchstone_build_options INTERFACE)
target_compile_features(touchstone_build_options INTERFACE cxx_std_20)
# Internal headers are included by their paths from the root.
target_include_directories(touchstone_build_options INTERFACE ${PROJECT_SOURCE_DIR})
# CGAL's numbers are GMP's here. Its headers read all of Boost.Multiprecision beside them unless told not to: a third of
# the time that they take to compile.
target_compile_definitions(touchstone_build_options INTERFACE CGAL_DO_NOT_USE_BOOST_MP $<$<PLATFORM_ID:Windows>:NOMINMAX>)
# A filter's bound holds for the operations as they are written.
set(touchstone_strict_arithmetic $<$<COMPILE_LANG_AND_ID:CXX,GNU,Clang,AppleClang>:$<$<BOOL:${MSVC}>:/clang:>-ffp-contract=off>)
if(MSVC)  # clang-cl, and for query and filters cl
  target_compile_options(touchstone_build_options INTERFACE /W4 /bigobj /utf-8 ${touchstone_strict_arithmetic})
else()
  target_compile_options(touchstone_build_options INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wcast-qual -Wold-style-cast
    -Wnon-virtual-dtor -Woverloaded-virtual -Wdouble-promotion -Wformat=2 -Wimplicit-fallthrough
    $<$<BOOL:${TOUCHSTONE_WERROR}>:-Werror>
    # The compiler collects its garbage only above 4 GB, which no source reaches: 7 % less time.
    $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=4000000>
    ${touchstone_strict_arithmetic}
    # GCC 12 for AArch64 puts a constant that it may not fold (-frounding-math, an option of CGAL's package) in the middle
    # of a block of constants, and then reads those behind it from wrong places.
    $<$<AND:$<CXX_COMPILER_ID:GNU>,$<STREQUAL:${CMAKE_SYSTEM_PROCESSOR},aarch64>>:-fno-section-anchors>
    # Clang 19 raises an alarm on the stable sort of GCC's library, which uses a deprecated function.
    $<$<CXX_COMPILER_ID:Clang>:-Wno-deprecated-declarations>
    # GCC 12 raises a false alarm on std::string's operator+ (its bug 105651).
    $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>)
endif()
if(TOUCHSTONE_SANITIZE)
  target_compile_options(touchstone_build_options INTERFACE
    -fsanitize=${TOUCHSTONE_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer
    # GCC 12 raises false alarms on std::regex under the sanitizers (its bug 105562).
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_compile_definitions(touchstone_build_options INTERFACE TOUCHSTONE_SANITIZED TOUCHSTONE_INLINE_CALLS=)
  target_link_options(touchstone_build_options INTERFACE -fsanitize=${TOUCHSTONE_SANITIZE})
endif()

# GCC 12 raises false alarms on std::string if its header is precompiled, or at -O1. For the affected targets.
set(touchstone_false_alarms
  "$<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-array-bounds;-Wno-stringop-overflow;-Wno-stringop-overread>")

# touchstone_for_python(TARGET): compiled for modules of Python too, which are shared libraries, if these are built.
function(touchstone_for_python target)
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ${TOUCHSTONE_BUILD_PYTHON})
endfunction()

# touchstone_compile_together(TARGET [PLANTED]): several sources of the target as one unit, which reads their headers once,
# if TOUCHSTONE_UNITY_BUILD is on. (CMAKE_UNITY_BUILD does so everywhere: preset lint.) PLANTED: the tests plant faults in
# its objects (tests/faults), which then have one source each.
function(touchstone_compile_together target)
  set(plants FALSE)
  if("${ARGN}" STREQUAL PLANTED AND TOUCHSTONE_BUILD_TESTS AND NOT "${TOUCHSTONE_FAULTS}" STREQUAL none)
    set(plants TRUE)
  endif()
  if(TOUCHSTONE_UNITY_BUILD AND NOT plants)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
  endif()
endfunction()

# touchstone_install(TARGET DEBIAN_PACKAGE [EXPORT NAME]): installs the library or program (is_built.cmake).
function(touchstone_install target package)
  if(TOUCHSTONE_INSTALL)
    install(TARGETS ${target} ${ARGN} COMPONENT ${package})
    get_target_property(type ${target} TYPE)
    if(NOT type STREQUAL "INTERFACE_LIBRARY")
      set_property(GLOBAL APPEND PROPERTY touchstone_installed "${target}|${package}|$<TARGET_FILE:${target}>")
    endif()
  endif()
endfunction()

# touchstone_install_component(TARGET): installs the library as a component of the package, touchstone-NAME-targets.cmake.
function(touchstone_install_component target)
  if(TOUCHSTONE_INSTALL)
    get_target_property(name ${target} EXPORT_NAME)
    touchstone_install(${target} libtouchstone-dev EXPORT touchstone-${name})
    install(EXPORT touchstone-${name} NAMESPACE touchstone:: DESTINATION ${touchstone_config_folder}
      FILE touchstone-${name}-targets.cmake)
  endif()
endfunction()

# touchstone_headers(TARGET INTERFACE|PUBLIC FOLDER HEADER…): the public headers, FOLDER/HEADER, which a user includes as
# <HEADER>. They are installed.
function(touchstone_headers target scope folder)
  target_include_directories(${target} ${scope}
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/${folder}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  foreach(header ${ARGN})
    if(TOUCHSTONE_INSTALL)
      get_filename_component(place ${CMAKE_INSTALL_INCLUDEDIR}/${header} DIRECTORY)
      install(FILES ${folder}/${header} DESTINATION ${place})
    endif()
  endforeach()
endfunction()

# touchstone_complete_headers(TARGET HEADER…): each header compiles by itself (target touchstone_complete_headers).
function(touchstone_complete_headers target)
  if(NOT TOUCHSTONE_BUILD_TESTS)
    return()
  endif()
  set(sources)
  foreach(header ${ARGN})
    set(source ${CMAKE_CURRENT_BINARY_DIR}/${target}_headers/${header}.cpp)
    file(CONFIGURE OUTPUT ${source} CONTENT "#include <${header}>\n")
    list(APPEND sources ${source})
  endforeach()
  add_library(${target}_headers OBJECT EXCLUDE_FROM_ALL ${sources})
  target_link_libraries(${target}_headers PRIVATE ${target})
  set_target_properties(${target}_headers PROPERTIES UNITY_BUILD OFF)
  if(NOT TARGET touchstone_complete_headers)
    add_custom_target(touchstone_complete_headers)
  endif()
  add_dependencies(touchstone_complete_headers ${target}_headers)
endfunction()

# touchstone_module(NAME [INTERFACE] HEADERS … SOURCES … PUBLIC … PRIVATE … PRECOMPILED …): the library
# touchstone_NAME, alias touchstone::NAME, with the packages and modules that it may use. HEADERS are the public
# headers, in include/touchstone/ of the module: a user includes <touchstone/HEADER>, and nothing else is on the user's
# include path. Each compiles by itself.
# PRECOMPILED are foreign headers that most sources read; a source still includes the headers that it uses. A module
# with headers is a component of the installed package, touchstone-NAME-targets.cmake.
function(touchstone_module name)
  cmake_parse_arguments(MODULE "INTERFACE" "" "HEADERS;SOURCES;PUBLIC;PRIVATE;PRECOMPILED" ${ARGN})
  set(target touchstone_${name})
  if(MODULE_INTERFACE)
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  else()
    add_library(${target} STATIC ${MODULE_SOURCES})
    set(scope PUBLIC)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:touchstone_build_options> ${MODULE_PRIVATE})
  endif()
  add_library(touchstone::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(${target} ${scope} cxx_std_20)
  target_link_libraries(${target} ${scope} ${MODULE_PUBLIC})
  target_precompile_headers(${target} PRIVATE ${MODULE_PRECOMPILED})
  if(MODULE_HEADERS)
    list(TRANSFORM MODULE_HEADERS PREPEND touchstone/)
    touchstone_headers(${target} ${scope} include ${MODULE_HEADERS})
    touchstone_complete_headers(${target} ${MODULE_HEADERS})
    touchstone_install_component(${target})
  endif()
endfunction()
