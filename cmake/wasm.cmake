# WebAssembly by Debian's emscripten; programs run under node and read the machine's files.
include(/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake)
set(Eigen3_DIR /usr/share/eigen3/cmake)
set(CMAKE_CXX_FLAGS_INIT "-fexceptions -include ${CMAKE_CURRENT_LIST_DIR}/old_libcxx.hpp")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-fexceptions -sNODERAWFS=1 -sALLOW_MEMORY_GROWTH=1 -sINITIAL_MEMORY=64MB -sTOTAL_STACK=16MB -sEXIT_RUNTIME=1")
