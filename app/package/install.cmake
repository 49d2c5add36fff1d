# What `cmake --install` and the Debian packages hold, in components: development (library, headers, how to find them),
# program (programs, examples, documentation) and, where it is built, python. docs/install.md is the page on it.
include(CMakePackageConfigHelpers)

# An installation says which registers it was compiled for; core/scalars/pack.hpp has the rule and obeys.
include(CheckCXXSourceCompiles)
set(CMAKE_REQUIRED_FLAGS -std=c++20)
if(LAGROID_ARCH)
  string(APPEND CMAKE_REQUIRED_FLAGS " -march=${LAGROID_ARCH}")
endif()
set(CMAKE_REQUIRED_INCLUDES ${PROJECT_BINARY_DIR}/include)
set(CMAKE_REQUIRED_LIBRARIES Eigen3::Eigen)
string(MAKE_C_IDENTIFIER "${LAGROID_ARCH}" instructions)
foreach(bytes 16 32 64)
  check_cxx_source_compiles("#include <lagroid/core/scalars/pack.hpp>
static_assert(lagroid::detail::register_lanes<double>() * sizeof(double) == ${bytes});
int main() {}" LAGROID_REGISTERS_${instructions}_${bytes})
  if(LAGROID_REGISTERS_${instructions}_${bytes})
    set(register_bytes ${bytes})
    break()
  endif()
endforeach()
unset(CMAKE_REQUIRED_FLAGS)
unset(CMAKE_REQUIRED_INCLUDES)
unset(CMAKE_REQUIRED_LIBRARIES)
if(NOT register_bytes)
  message(FATAL_ERROR "core/scalars/pack.hpp does not compile, or its registers have a size that app/package/install.cmake does not "
                      "know; see CMakeFiles/CMakeError.log in ${PROJECT_BINARY_DIR}")
endif()
get_target_property(definitions lagroid_core INTERFACE_COMPILE_DEFINITIONS)
list(APPEND definitions LAGROID_REGISTER_BYTES=${register_bytes})
target_compile_definitions(lagroid_core INTERFACE $<INSTALL_INTERFACE:LAGROID_REGISTER_BYTES=${register_bytes}>)

# development
foreach(folder core groupoids systems solvers run)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lagroid COMPONENT development
          FILES_MATCHING PATTERN "*.hpp" PATTERN "hdf5_file.hpp" EXCLUDE PATTERN "ipopt_program.hpp" EXCLUDE)  # they need others' headers
endforeach()
# Paths and names of the minor version before.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/compat/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lagroid COMPONENT development)
set(cmake_folder ${CMAKE_INSTALL_LIBDIR}/cmake/lagroid)
foreach(part core lagroid laws)
  set(target lagroid_${part})
  if(part STREQUAL "lagroid")
    set(target lagroid)
  endif()
  install(TARGETS ${target} EXPORT lagroid-${part}-targets COMPONENT development)
  install(EXPORT lagroid-${part}-targets NAMESPACE lagroid:: DESTINATION ${cmake_folder} COMPONENT development)
endforeach()
if(LAGROID_APP)
  install(TARGETS lagroid_run lagroid_machine EXPORT lagroid-run-targets COMPONENT development)
  install(EXPORT lagroid-run-targets NAMESPACE lagroid:: DESTINATION ${cmake_folder} COMPONENT development)
  # What programs of one's own are made of.
  install(TARGETS lagroid_commands lagroid_viewer EXPORT lagroid-commands-targets COMPONENT development)
  install(EXPORT lagroid-commands-targets NAMESPACE lagroid:: DESTINATION ${cmake_folder} COMPONENT development)
  install(TARGETS lagroid_derivatives EXPORT lagroid-derivatives-targets COMPONENT development)
  install(EXPORT lagroid-derivatives-targets NAMESPACE lagroid:: DESTINATION ${cmake_folder} COMPONENT development)
  install(FILES ${PROJECT_SOURCE_DIR}/app/own_poisson.hpp ${PROJECT_SOURCE_DIR}/app/own_program.hpp
                ${PROJECT_SOURCE_DIR}/app/program.hpp
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lagroid/app COMPONENT development)
  foreach(folder own reading keys scenes reductions families command check gradient poisson)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/app/${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lagroid/app
            COMPONENT development FILES_MATCHING PATTERN "*.hpp" PATTERN "templates" EXCLUDE
            PATTERN "minima" EXCLUDE PATTERN "spheres" EXCLUDE)  # of gradient: they need other folders
  endforeach()
  install(FILES ${PROJECT_BINARY_DIR}/installed/own_program.json DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/lagroid
          COMPONENT development)
endif()
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/lagroid-config.cmake.in ${PROJECT_BINARY_DIR}/lagroid-config.cmake
                              INSTALL_DESTINATION ${cmake_folder})
# While the major version is 0, the minor one says what goes together.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lagroid-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lagroid-config.cmake ${PROJECT_BINARY_DIR}/lagroid-config-version.cmake
        DESTINATION ${cmake_folder} COMPONENT development)

set(flags ${definitions})
list(TRANSFORM flags PREPEND -D)
if(LAGROID_ARCH)
  list(APPEND flags -march=${LAGROID_ARCH})
endif()
list(APPEND flags ${needed})
list(JOIN flags " " flags)
list(JOIN tuning " " tuning)
file(RELATIVE_PATH to_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" to_prefix ${to_prefix})
set(pc_requires "")
set(pc_libs "")
if(LAGROID_TBB)
  set(pc_requires " tbb")
endif()
if(LAGROID_CERES)
  set(pc_libs " -lceres -lglog")
endif()
configure_file(${CMAKE_CURRENT_LIST_DIR}/lagroid.pc.in ${PROJECT_BINARY_DIR}/lagroid.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/lagroid.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

# program
set(documentation ${CMAKE_INSTALL_DATAROOTDIR}/doc/lagroid)
if(LAGROID_APP)
  # Libraries outside the places that a loader looks in are found by what is installed too, one component at a time.
  set_target_properties(lagroid_cli lagroid_check lagroid_gradient PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)
  set_target_properties(lagroid_cli PROPERTIES EXPORT_NAME program)
  install(TARGETS lagroid_cli EXPORT lagroid-program-targets COMPONENT program)
  install(EXPORT lagroid-program-targets NAMESPACE lagroid:: DESTINATION ${cmake_folder} COMPONENT program)
  # Where it was built.
  install(TARGETS lagroid_check lagroid_gradient COMPONENT program OPTIONAL)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/lagroid COMPONENT program
          PATTERN CMakeLists.txt EXCLUDE)
  # Pages that speak of examples/ find them.
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/links)
  file(CREATE_LINK ../../lagroid/examples ${PROJECT_BINARY_DIR}/links/examples SYMBOLIC)
  install(DIRECTORY ${PROJECT_BINARY_DIR}/links/ DESTINATION ${documentation} COMPONENT program)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${documentation} COMPONENT program
          FILES_MATCHING PATTERN "*.md" PATTERN "*.svg")
  install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_SOURCE_DIR}/CONTRIBUTING.md
                ${PROJECT_SOURCE_DIR}/CITATION.cff
          DESTINATION ${documentation} COMPONENT program)
endif()

# python: see python/CMakeLists.txt.

if(PROJECT_IS_TOP_LEVEL)
  include(${CMAKE_CURRENT_LIST_DIR}/debian.cmake)
endif()
