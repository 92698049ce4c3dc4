# cmake -DVERSION=… -DSOURCE=FOLDER -DOUTPUT=FILE -P version.cmake: writes the version, with the commit of FOLDER, as the
# function version() of verify/cli/options.hpp (FILE.cpp) or as Python (FILE.py). The file is touched only if its text
# changes.
set(text "${VERSION}")
execute_process(COMMAND git describe --always --dirty --abbrev=10 --exclude=*
  WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit "")
else()
  string(APPEND text " (${commit})")
endif()
if(OUTPUT MATCHES "\\.py$")
  file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[
version = "@VERSION@"
commit = "@commit@"
]] @ONLY)
  return()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[
#include <string_view>

namespace touchstone::verify::cli {

std::string_view version();  // verify/cli/options.hpp, which takes seconds to compile
std::string_view version() { return "@text@"; }

}  // namespace touchstone::verify::cli
]] @ONLY)
