# cmake -DFOLDER=… -DPATCHELF=… -P self_contained.cmake: copies the shared libraries that the programs and modules below
# FOLDER need into FOLDER/lib, and lets all find them there. The C and C++ runtimes stay those of the machine.
if(NOT PATCHELF)
  message(FATAL_ERROR "the wheel needs the program patchelf")
endif()
file(GLOB modules ${FOLDER}/*.so ${FOLDER}/bin/*.so)
file(GLOB programs ${FOLDER}/bin/touchstone)
file(GET_RUNTIME_DEPENDENCIES EXECUTABLES ${programs} MODULES ${modules}
  PRE_EXCLUDE_REGEXES "^ld-linux" "^lib(c|m|gcc_s|stdc\\+\\+)[.]so"
  RESOLVED_DEPENDENCIES_VAR libraries)
file(MAKE_DIRECTORY ${FOLDER}/lib)
set(copies)
foreach(library ${libraries})
  cmake_path(GET library FILENAME name)
  file(REAL_PATH ${library} file)  # a wheel has no links
  configure_file(${file} ${FOLDER}/lib/${name} COPYONLY)
  list(APPEND copies ${FOLDER}/lib/${name})
endforeach()
# The older kind of path, which also holds for the libraries of libraries.
foreach(file ${programs} ${modules} ${copies})
  cmake_path(RELATIVE_PATH file BASE_DIRECTORY ${FOLDER} OUTPUT_VARIABLE place)
  string(REGEX REPLACE "[^/]+$" "" up "${place}")
  string(REGEX REPLACE "[^/]+/" "../" up "${up}")
  execute_process(COMMAND ${PATCHELF} --force-rpath --set-rpath "\$ORIGIN/${up}lib" ${file} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
