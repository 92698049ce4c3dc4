# cmake -DVERSION=… -DSOURCE=FOLDER -DOUTPUT=FILE.cpp -P version.cmake: writes the function version() of
# verify/cli/version.hpp, with the commit of FOLDER. The file is touched only if its text changes.
set(text "${VERSION}")
execute_process(COMMAND git describe --always --dirty --abbrev=10 --exclude=*
  WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(NOT failed)
  string(APPEND text " (${commit})")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[
#include "verify/cli/version.hpp"

namespace touchstone::verify::cli {

std::string_view version() { return "@text@"; }

}  // namespace touchstone::verify::cli
]] @ONLY)
