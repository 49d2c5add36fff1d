# The Debian packages: `cpack` in a build folder, or `./lagroid package`. One package for each component.
set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS OFF)
set(CPACK_PACKAGE_NAME lagroid)
set(CPACK_PACKAGE_VENDOR "The Lagroid authors")
set(CPACK_PACKAGE_CONTACT "The Lagroid authors <lagroid@lagroid.invalid>")
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX ${CMAKE_INSTALL_PREFIX})

set(runs_on "It runs on every amd64 processor; build from source for the
vector registers of one of your own.")
if(LAGROID_ARCH)
  set(runs_on "It was compiled
with -march=${LAGROID_ARCH}, and runs on no lesser processor.")
endif()

set(CPACK_COMPONENTS_ALL development)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME liblagroid-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libeigen3-dev (>= 3.4), libceres-dev (>= 2.1), libfmt-dev (>= 9), libtbb-dev, libxsimd-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "librapidcheck-dev, libhdf5-dev, nlohmann-json3-dev, libcli11-dev, libtomlplusplus-dev, libboost-dev, \
libmuparser-dev, libopenmpi-dev, g++, cmake, pkg-config")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS lagroid)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "Write a groupoid, a discrete Lagrangian and constraints, and get a
structure-preserving integrator, an optimal-control solver and a ledger of
what was kept and what was not.
.
This package holds the static library, its headers, and the files for CMake
and pkg-config. ${runs_on}")
if(LAGROID_APP)
  list(APPEND CPACK_COMPONENTS_ALL program)
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME lagroid)
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "gnuplot-nox | gnuplot")
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS openmpi-bin)
  set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "Runs scenes: rigid bodies, pendula, orbits, rolling, optimal control, chains
of bodies with joints and effects, minimisation on manifolds, and the
learning of Hamiltonians from trajectories. Every run ends with a ledger of
what its method promises and what was found.
.
This package holds the program, its examples and its documentation.")
endif()
if(TARGET lagroid_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-lagroid)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.11), python3 (<< 3.12), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-matplotlib, lagroid")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "liblagroid-dev, pybind11-dev")
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION "Scenes, systems, runs, studies, checks, optimisation and learning from
Python, with NumPy arrays.
.
This package holds the Python module.")
endif()

# What Debian asks of every package: its licence and, in Debian's form, what has changed.
string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
set(changelog ${PROJECT_BINARY_DIR}/debian/changelog)
file(WRITE ${changelog} "lagroid (${PROJECT_VERSION}) bookworm; urgency=medium

  * See /usr/share/doc/lagroid/CHANGELOG.md of the package lagroid.

 -- ${CPACK_PACKAGE_CONTACT}  ${now}
")
execute_process(COMMAND gzip -9nf ${changelog} COMMAND_ERROR_IS_FATAL ANY)
foreach(component ${CPACK_COMPONENTS_ALL})
  string(TOUPPER ${component} upper)
  set(folder ${CMAKE_INSTALL_DATAROOTDIR}/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${folder} COMPONENT ${component} RENAME copyright)
  install(FILES ${changelog}.gz DESTINATION ${folder} COMPONENT ${component})
endforeach()
include(CPack)
