# Writes the texts that a page is made of as a C++ source:
# cmake -DOUTPUT=… -DD3=… -DSCRIPT=… -DSTYLE=… -P embed.cmake
set(source "// Made by verify/report/page/embed.cmake.\n#include \"verify/report/page_texts.hpp\"\n\n")
string(APPEND source "namespace touchstone::verify::report {\n")
foreach(pair "d3_script;${D3}" "page_script;${SCRIPT}" "page_style;${STYLE}")
  list(GET pair 0 function)
  list(GET pair 1 path)
  file(READ "${path}" text)
  string(FIND "${text}" ")touchstone\"" delimiter)
  if(NOT delimiter EQUAL -1)
    message(FATAL_ERROR "${path} holds the end of a raw string")
  endif()
  string(APPEND source
    "\nstd::string_view ${function}() {\n  return R\"touchstone(${text})touchstone\";\n}\n")
endforeach()
string(APPEND source "\n}  // namespace touchstone::verify::report\n")
file(WRITE "${OUTPUT}" "${source}")
