# ccache in front of the compiler, if it is installed (see compile.sh).
option(TOUCHSTONE_CCACHE "Compile through ccache, where it is installed" ${PROJECT_IS_TOP_LEVEL})
find_program(TOUCHSTONE_CCACHE_PROGRAM ccache)
if(TOUCHSTONE_CCACHE AND TOUCHSTONE_CCACHE_PROGRAM)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${PROJECT_SOURCE_DIR}/cmake/compile.sh ${PROJECT_SOURCE_DIR})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # GCC mentions the precompiled header that it uses only with this option.
    add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-fpch-preprocess>)
  endif()
endif()
