# How every target of the project is compiled.

set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

add_library(touchstone_build_options INTERFACE)
target_compile_features(touchstone_build_options INTERFACE cxx_std_20)
target_compile_options(touchstone_build_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wcast-qual -Wold-style-cast
  -Wnon-virtual-dtor -Woverloaded-virtual -Wdouble-promotion -Wformat=2 -Wimplicit-fallthrough -Werror
  # A filter's bound belongs to the operations as they are written.
  -ffp-contract=off
  # GCC 12 raises a false alarm on std::string's operator+ (its bug 105651).
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>)
if(TOUCHSTONE_SANITIZE)
  target_compile_options(touchstone_build_options INTERFACE
    -fsanitize=${TOUCHSTONE_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer
    # GCC 12 raises false alarms on std::regex under the sanitizers (its bug 105562).
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(touchstone_build_options INTERFACE -fsanitize=${TOUCHSTONE_SANITIZE})
endif()

# GCC 12 raises false alarms on std::string where its header is precompiled, or at -O1. For the targets that meet them.
set(touchstone_false_alarms
  "$<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-array-bounds;-Wno-stringop-overflow;-Wno-stringop-overread>")

# touchstone_room(NAME [INTERFACE] HEADERS ... SOURCES ... PUBLIC ... PRIVATE ... PRECOMPILED ...): the library
# touchstone_NAME, alias touchstone::NAME, with the packages and rooms it may use and no others.
# HEADERS are what a user of the library includes; they are installed. PRECOMPILED are headers of others that most
# sources read; a source still includes what it uses.
function(touchstone_room name)
  cmake_parse_arguments(ROOM "INTERFACE" "" "HEADERS;SOURCES;PUBLIC;PRIVATE;PRECOMPILED" ${ARGN})
  set(target touchstone_${name})
  if(ROOM_INTERFACE)
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  else()
    add_library(${target} STATIC ${ROOM_SOURCES})
    set(scope PUBLIC)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:touchstone_build_options> ${ROOM_PRIVATE})
  endif()
  add_library(touchstone::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(${target} ${scope} cxx_std_20)
  target_include_directories(${target} ${scope}
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/touchstone>)
  target_link_libraries(${target} ${scope} ${ROOM_PUBLIC})
  target_precompile_headers(${target} PRIVATE ${ROOM_PRECOMPILED})
  if(ROOM_HEADERS)
    get_filename_component(room ${CMAKE_CURRENT_SOURCE_DIR} NAME)
    foreach(header ${ROOM_HEADERS})
      get_filename_component(folder ${room}/${header} DIRECTORY)
      install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/touchstone/${folder})
    endforeach()
    install(TARGETS ${target} EXPORT touchstone)
  endif()
endfunction()
