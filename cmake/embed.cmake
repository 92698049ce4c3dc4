# Writes texts as functions of a C++ source that return them:
# cmake -DOUTPUT=… -DHEADER=… -DNAMESPACE=… "-DTEXTS=FUNCTION=PATH;…" -P embed.cmake
set(source "// Made by cmake/embed.cmake.\n#include \"${HEADER}\"\n\n")
string(APPEND source "namespace ${NAMESPACE} {\n")
foreach(pair IN LISTS TEXTS)
  string(REGEX MATCH "^([a-z0-9_]+)=(.*)$" matched "${pair}")
  set(function ${CMAKE_MATCH_1})
  set(path ${CMAKE_MATCH_2})
  file(READ "${path}" text)
  string(FIND "${text}" ")touchstone\"" delimiter)
  if(NOT delimiter EQUAL -1)
    message(FATAL_ERROR "${path} holds the end of a raw string")
  endif()
  string(APPEND source
    "\nstd::string_view ${function}() {\n  return R\"touchstone(${text})touchstone\";\n}\n")
endforeach()
string(APPEND source "\n}  // namespace ${NAMESPACE}\n")
file(WRITE "${OUTPUT}" "${source}")
