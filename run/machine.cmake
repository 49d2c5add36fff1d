# lagroid_machine: what a program is, so that it can tell its own work from another's. The hash of what enters numbers
# is made when one of these files changes, and stands in a file of its own, so that nothing else is compiled for it.
file(GLOB_RECURSE sources_of_numbers CONFIGURE_DEPENDS
  ${PROJECT_SOURCE_DIR}/core/*.[ch]pp
  ${PROJECT_SOURCE_DIR}/groupoids/*.[ch]pp
  ${PROJECT_SOURCE_DIR}/solvers/*.[ch]pp
  ${PROJECT_SOURCE_DIR}/systems/*.[ch]pp
  # How scenes become systems, and what is recorded of them.
  ${PROJECT_SOURCE_DIR}/run/motion/*.[ch]pp
  ${PROJECT_SOURCE_DIR}/run/followed_run.[ch]pp
  ${PROJECT_SOURCE_DIR}/run/ledger/judge.[ch]pp
  ${PROJECT_SOURCE_DIR}/run/ledger/ledger.[ch]pp
  ${PROJECT_SOURCE_DIR}/run/files/archive.hpp
  ${PROJECT_SOURCE_DIR}/app/bodies/*.[ch]pp
  ${PROJECT_SOURCE_DIR}/app/families/*_family.cpp
  ${PROJECT_SOURCE_DIR}/app/reading/*.[ch]pp
  ${PROJECT_SOURCE_DIR}/app/scenes/*.[ch]pp
  ${PROJECT_SOURCE_DIR}/app/spheres/*.[ch]pp
  ${PROJECT_SOURCE_DIR}/app/sweep/*.[ch]pp
  ${PROJECT_SOURCE_DIR}/app/systems/*.[ch]pp)
list(FILTER sources_of_numbers EXCLUDE REGEX "/testing/|/certificates/")
list(APPEND sources_of_numbers ${PROJECT_SOURCE_DIR}/CMakeLists.txt)  # flags of single files

set(machine_folder ${PROJECT_BINARY_DIR}/machine)
string(TOUPPER "${CMAKE_BUILD_TYPE}" configuration)
list(JOIN sources_of_numbers "\n" lines)
file(CONFIGURE OUTPUT ${machine_folder}/sources.txt CONTENT "${lines}" @ONLY)
file(GENERATE OUTPUT ${machine_folder}/build.txt CONTENT
"${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}
${CMAKE_BUILD_TYPE} ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${configuration}}
$<FILTER:$<TARGET_PROPERTY:lagroid_part_base,COMPILE_OPTIONS>,EXCLUDE,^-W>
$<TARGET_PROPERTY:lagroid_core,INTERFACE_COMPILE_OPTIONS>
$<TARGET_PROPERTY:lagroid_core,INTERFACE_COMPILE_DEFINITIONS>
Eigen ${Eigen3_VERSION}, Ceres ${Ceres_VERSION}, Boost ${Boost_VERSION}
Spectra ${Spectra_VERSION}, xsimd ${xsimd_VERSION}
")
add_custom_command(
  OUTPUT ${machine_folder}/build_hash.cpp
  COMMAND ${CMAKE_COMMAND} -D FOLDER=${machine_folder} -D ROOT=${PROJECT_SOURCE_DIR} -D COMPILER=${CMAKE_CXX_COMPILER}
          -D COMPILER_ID=${CMAKE_CXX_COMPILER_ID} -D ARCH=${LAGROID_ARCH} -P ${CMAKE_CURRENT_LIST_DIR}/build_hash.cmake
  DEPENDS ${sources_of_numbers} ${machine_folder}/sources.txt ${machine_folder}/build.txt ${CMAKE_CURRENT_LIST_DIR}/build_hash.cmake
  COMMENT "Hash of what enters numbers"
  VERBATIM)

add_library(lagroid_machine STATIC ${CMAKE_CURRENT_LIST_DIR}/machine.cpp ${machine_folder}/build_hash.cpp)
set_target_properties(lagroid_machine PROPERTIES POSITION_INDEPENDENT_CODE ON)
target_include_directories(lagroid_machine PRIVATE ${CMAKE_CURRENT_LIST_DIR})
target_link_libraries(lagroid_machine PRIVATE $<BUILD_INTERFACE:lagroid_compiled> $<BUILD_INTERFACE:lagroid_warnings>)
set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/machine.cpp PROPERTIES COMPILE_DEFINITIONS
  "LAGROID_ARCH=\"${LAGROID_ARCH}\";LAGROID_COMPILER=\"${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}\"")
