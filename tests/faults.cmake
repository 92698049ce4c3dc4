# Planted faults: sources of the project compiled from their own text with something replaced, under other names.
# Not under the sanitizers, which have nothing to find in them.

# with_fault(FILE FOLDER ORIGINAL FAULT [ORIGINAL FAULT]…): writes FILE so altered under FOLDER, every place of each
# ORIGINAL. (No semicolon within these: CMake takes it for the end of an argument.)
function(with_fault file folder)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${file})
  file(READ ${PROJECT_SOURCE_DIR}/${file} text)
  set(replacements ${ARGN})
  while(replacements)
    list(POP_FRONT replacements original fault)
    string(FIND "${text}" "${original}" place)
    if(place EQUAL -1)
      message(FATAL_ERROR "${folder}: nothing to replace in ${file}: ${original}")
    endif()
    string(REPLACE "${original}" "${fault}" text "${text}")
  endwhile()
  file(CONFIGURE OUTPUT ${folder}/${file} CONTENT "${text}" @ONLY)
endfunction()

# object_with_names(NAME SOURCES INCLUDE_FOLDERS…): an object library of sources that stand for others, which the
# folders hold in altered form or as replacements.
function(object_with_names name sources)
  add_library(${name} OBJECT ${sources})
  target_compile_features(${name} PRIVATE cxx_std_20)
  # The code of others (SIMDe) and altered code are not held to this project's warnings.
  target_compile_options(${name} PRIVATE -O1 -ffp-contract=off -Wno-psabi)
  target_compile_definitions(${name} PRIVATE EIGEN_DONT_VECTORIZE)
  target_include_directories(${name} BEFORE PRIVATE ${ARGN})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE touchstone::query)
endfunction()

# object_under_name(NAME SOURCE SYMBOL FOLDER [SYMBOL_2]): SOURCE from FOLDER, with SYMBOL called NAME.
function(object_under_name name source symbol folder)
  set(renamed "#define ${symbol} ${name}\n")
  foreach(other ${ARGN})
    string(APPEND renamed "#define ${other} ${name}_${other}\n")
  endforeach()
  file(CONFIGURE OUTPUT ${folder}/${name}.cpp CONTENT "${renamed}#include \"${source}\"\n")
  object_with_names(${name} ${folder}/${name}.cpp ${folder})
endfunction()

function(folder_of_fault variable name)
  set(${variable} ${PROJECT_BINARY_DIR}/tests/faults/${name} PARENT_SCOPE)
endfunction()

# faulty_kernel(FILE NAME ORIGINAL FAULT [ORIGINAL FAULT]…): fast::NAME, the certified solver's scalar kernel with a
# fault in one of its files.
function(faulty_kernel file name)
  folder_of_fault(folder ${name})
  with_fault(${file} ${folder} ${ARGN})
  object_under_name(${name} fast/certified/kernel_scalar.cpp scalar_certified_kernel ${folder})
endfunction()

# faulty_exact_stage(FILE NAME …): fast::NAME, decide_exactly with a fault; in several files since some of its sources
# use the same names for their own.
function(faulty_exact_stage file name)
  folder_of_fault(folder ${name})
  with_fault(${file} ${folder} ${ARGN})
  set(renamed "#define exact_stage ${name}_stage\n#define decide_exactly ${name}\n")
  set(from "#include \"fast/certified/")
  file(CONFIGURE OUTPUT ${folder}/quick.cpp CONTENT
    "${renamed}${from}quick_decision.cpp\"\n${from}exact_stage.cpp\"\n")
  file(CONFIGURE OUTPUT ${folder}/general.cpp CONTENT
    "${renamed}${from}big_integer.cpp\"\n${from}algebraic_instant.cpp\"\n${from}general_decision.cpp\"\n")
  file(CONFIGURE OUTPUT ${folder}/separated.cpp CONTENT
    "${renamed}${from}rough_form.cpp\"\n${from}nearest_parameters.cpp\"\n${from}separated_decision.cpp\"\n")
  object_with_names(${name} "${folder}/quick.cpp;${folder}/general.cpp;${folder}/separated.cpp" ${folder})
endfunction()

# faulty_box_kernel(FILE NAME …): fast::NAME, Tight-Inclusion's scalar kernel with a fault in one of its files.
function(faulty_box_kernel file name)
  folder_of_fault(folder ${name})
  with_fault(${file} ${folder} ${ARGN})
  object_under_name(${name} fast/tight_inclusion/box_kernel_scalar.cpp scalar_box_kernel ${folder}
    scalar_released_box_kernel)
endfunction()

# faulty_search(NAME …): fast::NAME, tight_inclusion_method with a fault in the search.
function(faulty_search name)
  folder_of_fault(folder ${name})
  with_fault(fast/tight_inclusion.cpp ${folder} ${ARGN})
  object_under_name(${name} fast/tight_inclusion.cpp tight_inclusion_method ${folder} tight_inclusion)
endfunction()
