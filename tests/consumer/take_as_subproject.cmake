# Takes the project by add_subdirectory, and runs a simulator; then by FetchContent, as far as configuring.
#   cmake -DTOUCHSTONE=<source folder> -DWORK=<scratch folder> -P take_as_subproject.cmake
set(most_objects 70)
find_program(CCACHE ccache)

# take(HOW): configures a project that takes this one, and checks the objects and files that it gets.
function(take how)
  set(build ${WORK}/${how})
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/subproject -B ${build} -G Ninja
      -DCMAKE_BUILD_TYPE=Release -DHOW=${how} -DTOUCHSTONE=${TOUCHSTONE} -DCMAKE_CXX_COMPILER_LAUNCHER=${CCACHE}
    COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
  file(READ ${build}/compile_commands.json commands)
  string(JSON objects LENGTH ${commands})
  message(STATUS "${how}: ${objects} objects")
  if(objects GREATER most_objects)
    message(FATAL_ERROR "${how} puts ${objects} objects into the user's build, more than ${most_objects}")
  endif()
  if(commands MATCHES "-Werror")
    message(FATAL_ERROR "${how} turns warnings into errors for a user")
  endif()
  file(READ ${build}/cmake_install.cmake rules)
  file(GLOB_RECURSE more ${build}/touchstone/*cmake_install.cmake ${build}/_deps/*cmake_install.cmake)
  foreach(file ${more})
    file(READ ${file} text)
    string(APPEND rules "${text}")
  endforeach()
  if(rules MATCHES "file\\(INSTALL")
    message(FATAL_ERROR "${how} installs files with the user's project")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
take(FetchContent)
take(add_subdirectory)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK}/add_subdirectory COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${WORK}/add_subdirectory/simulator COMMAND_ERROR_IS_FATAL ANY)
file(REMOVE_RECURSE ${WORK})
