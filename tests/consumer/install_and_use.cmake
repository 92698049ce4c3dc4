# Installs the build into a folder of its own, builds the consumer against it and runs its programs.
#   cmake -DBUILD=<build folder> -DWORK=<scratch folder> -P install_and_use.cmake
function(step)
  execute_process(COMMAND ${ARGV} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK})
step(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
step(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK}/build -G Ninja -DCMAKE_BUILD_TYPE=Release
     -DCMAKE_PREFIX_PATH=${WORK}/prefix)
step(${CMAKE_COMMAND} --build ${WORK}/build)
step(${WORK}/build/researcher)
step(${WORK}/build/simulator)
step(${WORK}/build/filter_author)
execute_process(COMMAND ldd ${WORK}/build/simulator OUTPUT_VARIABLE libraries COMMAND_ERROR_IS_FATAL ANY)
if(libraries MATCHES "gmp|mpfr|CGAL|boost")
  message(FATAL_ERROR "a program that links touchstone::fast needs an exact library:\n${libraries}")
endif()
step(${WORK}/prefix/bin/touchstone --version)
file(REMOVE_RECURSE ${WORK})
