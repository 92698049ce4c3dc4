# Files of other tools name the version of CMakeLists.txt.
#   cmake -DTOUCHSTONE=<source folder> -DVERSION=<version> -P names_one_version.cmake
function(expect file text)
  file(READ ${TOUCHSTONE}/${file} content)
  string(FIND "${content}" "${text}" place)
  if(place EQUAL -1)
    message(SEND_ERROR "${file} does not say '${text}', the version of CMakeLists.txt")
  endif()
endfunction()
expect(packaging/vcpkg.json "\"version\": \"${VERSION}\"")
expect(CITATION.cff "version: ${VERSION}\n")
expect(CHANGELOG.md "## ${VERSION}\n")
string(REGEX REPLACE "[.][0-9]+$" "" compatible ${VERSION})
expect(docs/install.md "find_package(touchstone ${compatible} ")
