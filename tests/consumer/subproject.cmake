# A simulator that takes the project by add_subdirectory or FetchContent, or installed without what needs more, on a machine
# with Eigen, oneTBB and no other of the project's packages.
# -DHOW=add_subdirectory|FetchContent|find_package -DTOUCHSTONE=<the project's folder> -DARCHIVE=<its archive, for FetchContent>
cmake_minimum_required(VERSION 3.22)
project(subproject LANGUAGES CXX)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
foreach(package CGAL Boost GMP MPFR fmt CLI11 nlohmann_json zstd GTest benchmark Python3)
  set(CMAKE_DISABLE_FIND_PACKAGE_${package} ON)
endforeach()
if(HOW STREQUAL "FetchContent")
  include(FetchContent)
  FetchContent_Declare(touchstone URL ${ARCHIVE})
  FetchContent_MakeAvailable(touchstone)
elseif(HOW STREQUAL "find_package")
  find_package(touchstone REQUIRED)  # the components that are installed
else()
  add_subdirectory(${TOUCHSTONE} touchstone)
endif()
add_executable(simulator ${TOUCHSTONE}/tests/consumer/simulator_author.cpp)
target_link_libraries(simulator PRIVATE touchstone::fast)
