# Every installation begins with this: what is to be installed and was not built is named, and nothing is installed.
# `installed` has TARGET|COMPONENT|FILE of each, `build` is the build folder.
foreach(entry ${installed})
  string(REGEX MATCH "^(.*)[|](.*)[|](.*)$" entry "${entry}")
  if(NOT EXISTS "${CMAKE_MATCH_3}" AND (NOT CMAKE_INSTALL_COMPONENT OR CMAKE_INSTALL_COMPONENT STREQUAL CMAKE_MATCH_2))
    string(APPEND missing " ${CMAKE_MATCH_1}")
    list(APPEND broken ${CMAKE_MATCH_2})
  endif()
  list(APPEND components ${CMAKE_MATCH_2})
endforeach()
if(missing)
  list(REMOVE_DUPLICATES components)
  list(REMOVE_ITEM components ${broken})
  message(FATAL_ERROR "not built, and so nothing is installed:${missing}\n"
    "Build all (cmake --build \"${build}\"), or install a part that was built (--component NAME): ${components}")
endif()
