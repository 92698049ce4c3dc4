# Planted faults: sources of the project compiled from their own text with something replaced, under other names. The tests
# of a part and the fuzzer have to find them (tests/fast/certified, tests/mutants). One a stage is planted in every build, and
# all of them where TOUCHSTONE_ALL_FAULTS asks for it (./run soak); a name that is not planted is a null address there.
# None under the sanitizers, which have nothing to find in them.

add_library(touchstone_planted_faults INTERFACE)

# is_planted(VARIABLE NAME): is this fault part of this build?
function(is_planted variable name)
  set(${variable} FALSE PARENT_SCOPE)
  if(NOT TOUCHSTONE_SANITIZE AND (TOUCHSTONE_ALL_FAULTS OR name IN_LIST faults_of_every_build))
    set(${variable} TRUE PARENT_SCOPE)
  endif()
endfunction()

# with_fault(VARIABLE FILES NAME ORIGINAL FAULT [ORIGINAL FAULT]…): writes FILES so altered, every place of each ORIGINAL in
# any of them, under a folder of that fault's own, which VARIABLE gets. (No semicolon within these: CMake takes it for the
# end of an argument.)
function(with_fault variable files name)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/${name})
  # Headers that an earlier version of the fault altered would hide the true ones.
  file(GLOB_RECURSE stale RELATIVE ${folder} ${folder}/*.hpp)
  list(REMOVE_ITEM stale ${files})
  foreach(file ${stale})
    file(REMOVE ${folder}/${file})
  endforeach()
  set(found)
  foreach(file ${files})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${file})
    file(READ ${PROJECT_SOURCE_DIR}/${file} text)
    set(replacements ${ARGN})
    while(replacements)
      list(POP_FRONT replacements original fault)
      string(FIND "${text}" "${original}" place)
      if(NOT place EQUAL -1)
        list(APPEND found "${original}")
        string(REPLACE "${original}" "${fault}" text "${text}")
      endif()
    endwhile()
    file(CONFIGURE OUTPUT ${folder}/${file} CONTENT "${text}" @ONLY)
  endforeach()
  set(replacements ${ARGN})
  while(replacements)
    list(POP_FRONT replacements original fault)
    if(NOT original IN_LIST found)
      message(FATAL_ERROR "${name}: nothing to replace in ${files}: ${original}")
    endif()
  endwhile()
  set(${variable} ${folder} PARENT_SCOPE)
endfunction()

# object_with_names(NAME SOURCE INCLUDE_FOLDERS…): an object library of a source that stands for another, which the
# folders hold in altered form or as a replacement.
function(object_with_names name source)
  add_library(${name} OBJECT EXCLUDE_FROM_ALL ${source})
  target_compile_features(${name} PRIVATE cxx_std_20)
  # The code of others (SIMDe) and altered code are not held to this project's warnings.
  target_compile_options(${name} PRIVATE -O1 -ffp-contract=off -Wno-psabi)
  target_compile_definitions(${name} PRIVATE EIGEN_DONT_VECTORIZE)
  target_include_directories(${name} BEFORE PRIVATE ${ARGN})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE touchstone::query)
endfunction()

# faulty(SOURCE SYMBOLS FILES NAME …): SOURCE with a fault in it or in headers that it includes, FILES; the first of its
# SYMBOLS is called NAME, any other NAME_SYMBOL.
function(faulty source symbols files name)
  # In every build, so that a fault without a place is told at once.
  with_fault(folder "${files}" ${name} ${ARGN})
  is_planted(planted ${name})
  if(NOT planted)
    return()
  endif()
  list(POP_FRONT symbols symbol)
  set(renamed "#define ${symbol} ${name}\n")
  foreach(other ${symbols})
    string(APPEND renamed "#define ${other} ${name}_${other}\n")
  endforeach()
  file(CONFIGURE OUTPUT ${folder}/${name}.cpp CONTENT "${renamed}#include \"${source}\"\n")
  object_with_names(${name} ${folder}/${name}.cpp ${folder})
  target_link_libraries(touchstone_planted_faults INTERFACE $<TARGET_OBJECTS:${name}>)
endfunction()

# faulty_kernel(FILES NAME ORIGINAL FAULT [ORIGINAL FAULT]…): fast::NAME, the certified solver's scalar kernel with a
# fault in some of its files.
function(faulty_kernel files name)
  faulty(fast/certified/kernel_scalar.cpp scalar_certified_kernel "${files}" ${name} ${ARGN})
endfunction()

# faulty_box_kernel(FILE NAME …): fast::NAME, Tight-Inclusion's scalar kernel with a fault in one of its files.
function(faulty_box_kernel file name)
  faulty(fast/tight_inclusion/box_kernel_scalar.cpp "scalar_box_kernel;scalar_released_box_kernel" ${file} ${name} ${ARGN})
endfunction()

# faulty_pairs(FILE NAME …): fast::NAME, the scalar search of the broad phase with a fault in one of its files.
function(faulty_pairs file name)
  faulty(fast/broad_phase/search_scalar.cpp scalar_search_kernel ${file} ${name} ${ARGN})
endfunction()

# faulty_bounds(NAME …): fast::NAME, the bounds of FloatBounds (vertex_bounds.cpp) with a fault in it.
function(faulty_bounds name)
  faulty(tests/faults/vertex_bounds.cpp "vertex_bounds;FloatBounds" fast/broad_phase/float_bounds.cpp ${name}
    ${ARGN})
endfunction()

# faulty_search(NAME …): fast::NAME, tight_inclusion_method with a fault in the search.
function(faulty_search name)
  faulty(fast/tight_inclusion.cpp "tight_inclusion_method;tight_inclusion" fast/tight_inclusion.cpp ${name} ${ARGN})
endfunction()

# faulty_exact_stage(SOURCE FILE NAME …): fast::NAME, decide_exactly with a fault in SOURCE, or in a header that it
# includes, FILE. Only SOURCE is compiled: the linker joins it to the other objects of the library, and all names but that
# of decide_exactly become local to the result.
function(faulty_exact_stage source file name)
  with_fault(folder ${file} ${name} ${ARGN})
  is_planted(planted ${name})
  if(NOT planted)
    return()
  endif()
  if(NOT source STREQUAL file)
    file(CONFIGURE OUTPUT ${folder}/${source} CONTENT "#include \"${PROJECT_SOURCE_DIR}/${source}\"\n")
  endif()
  object_with_names(${name}_part ${folder}/${source} ${folder})
  set(object ${folder}/${name}.o)
  add_custom_command(OUTPUT ${object}
    COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/join_objects.sh decide_exactly ${name} ${object}
            $<TARGET_OBJECTS:${name}_part> $<TARGET_FILE:touchstone_fast>
    DEPENDS join_objects.sh $<TARGET_OBJECTS:${name}_part> touchstone_fast
    COMMAND_EXPAND_LISTS VERBATIM)
  add_custom_target(${name} DEPENDS ${object})
  target_link_libraries(touchstone_planted_faults INTERFACE ${object})
  add_dependencies(touchstone_planted_faults ${name})
endfunction()

# faulty_distance(STAGE FILE NAME …): fast::NAME, a stage of the distance, exact or filtered, with a fault in one of its
# files. Other names too are changed: what is inline must not be taken for the true one.
function(faulty_distance stage file name)
  faulty(fast/distance/${stage}_distance.cpp "${stage}_distance;polygon;BallOf" ${file} ${name} ${ARGN})
endfunction()

# faulty_line_search(NAME …): fast::NAME, line_search_limit with a fault.
function(faulty_line_search name)
  faulty(fast/line_search.cpp line_search_limit fast/line_search.cpp ${name} ${ARGN})
endfunction()

# faulty_checker(FILE NAME …): tests::NAME, the checker (checker_of_steps.cpp) with a fault in one of its files.
function(faulty_checker file name)
  faulty(tests/faults/checker_of_steps.cpp "checker_of_steps;checker" ${file} ${name} ${ARGN})
endfunction()
