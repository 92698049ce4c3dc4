# Installs the build into a separate folder, builds the consumer against it and runs its programs; then by pkg-config.
#   cmake -DBUILD=<build folder> -DWORK=<scratch folder> -DVERSION=<major.minor> -P install_and_use.cmake
function(step)
  execute_process(COMMAND ${ARGV} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK})
# What was not built is named before anything is installed.
execute_process(COMMAND ${CMAKE_COMMAND} "-Dinstalled=touchstone_c|library|${WORK}/none;touchstone_check|checker|${CMAKE_COMMAND}"
    -P ${CMAKE_CURRENT_LIST_DIR}/../../cmake/is_built.cmake
  RESULT_VARIABLE status ERROR_VARIABLE message)
if(status EQUAL 0 OR NOT message MATCHES "installed: touchstone_c\n.*component[ \n]+NAME[)]:[ \n]+checker")
  message(FATAL_ERROR "an unfinished build is installed, or the message does not say what to build: ${message}")
endif()
step(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
step(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK}/build -G Ninja -DCMAKE_BUILD_TYPE=Release
     -DCMAKE_PREFIX_PATH=${WORK}/prefix -DVERSION=${VERSION})
step(${CMAKE_COMMAND} --build ${WORK}/build)
step(${WORK}/build/researcher)
step(${WORK}/build/simulator)
step(${WORK}/build/prover ${WORK}/step.cert ${WORK}/mesh.cert)
step(${WORK}/prefix/bin/touchstone-check --claim earliest --separation 0 ${WORK}/step.cert)
step(${WORK}/prefix/bin/touchstone-check --claim free ${WORK}/mesh.cert)
step(${WORK}/build/filter_author)
step(${WORK}/build/ticcd_caller)

# run_program_in_c(PROGRAM): it ends with 1 for a collision.
function(run_program_in_c program)
  execute_process(COMMAND ${program} RESULT_VARIABLE status)
  if(NOT status EQUAL 1)
    message(FATAL_ERROR "${program} ended with ${status}, not with 1 for a collision")
  endif()
endfunction()
run_program_in_c(${WORK}/build/c_caller)
run_program_in_c(${WORK}/build/c_static_caller)
execute_process(COMMAND ldd ${WORK}/build/simulator OUTPUT_VARIABLE libraries COMMAND_ERROR_IS_FATAL ANY)
if(libraries MATCHES "gmp|mpfr|CGAL|boost")
  message(FATAL_ERROR "a program that links touchstone::fast needs an exact library:\n${libraries}")
endif()
step(${WORK}/prefix/bin/touchstone --version)

# compile_by_pkg_config(PACKAGE PROGRAM SOURCE COMPILER…): the program, with the package's flags and no others.
find_program(PKG_CONFIG pkg-config REQUIRED)
file(GLOB_RECURSE package_files ${WORK}/prefix/*/touchstone-fast.pc)
get_filename_component(packages ${package_files} DIRECTORY)
function(compile_by_pkg_config package program source)
  set(ENV{PKG_CONFIG_PATH} ${packages})
  execute_process(COMMAND ${PKG_CONFIG} --cflags --libs ${package} OUTPUT_VARIABLE flags COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(flags UNIX_COMMAND "${flags}")
  step(${ARGN} ${source} -o ${WORK}/${program} ${flags})
endfunction()
compile_by_pkg_config(touchstone-fast simulator ${CMAKE_CURRENT_LIST_DIR}/simulator_author.cpp c++ -std=c++20)
step(${WORK}/simulator)
compile_by_pkg_config(touchstone-exact researcher ${CMAKE_CURRENT_LIST_DIR}/researcher.cpp c++ -std=c++20)
step(${WORK}/researcher)
compile_by_pkg_config(touchstone-c c_caller ${CMAKE_CURRENT_LIST_DIR}/../../examples/library/step.c cc)
compile_by_pkg_config(touchstone-c_static c_static_caller ${CMAKE_CURRENT_LIST_DIR}/../../examples/library/step.c cc)
run_program_in_c(${WORK}/c_static_caller)
set(ENV{LD_LIBRARY_PATH} ${packages}/..)
run_program_in_c(${WORK}/c_caller)

# Without components find_package takes those that are installed.
file(GLOB_RECURSE more ${WORK}/prefix/*/touchstone-exact-*.cmake ${WORK}/prefix/*/touchstone-derivation-*.cmake
  ${WORK}/prefix/*/touchstone-scene_certificates-*.cmake)
file(REMOVE ${more})
file(MAKE_DIRECTORY ${WORK}/user)
file(COPY_FILE ${CMAKE_CURRENT_LIST_DIR}/subproject.cmake ${WORK}/user/CMakeLists.txt)
step(${CMAKE_COMMAND} -S ${WORK}/user -B ${WORK}/part -G Ninja -DCMAKE_PREFIX_PATH=${WORK}/prefix -DHOW=find_package
     -DTOUCHSTONE=${CMAKE_CURRENT_LIST_DIR}/../..)
file(REMOVE_RECURSE ${WORK})
