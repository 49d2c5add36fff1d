# The systems that scenes, checks and Python know, in the order in which they are listed to users: systems/NAME.hpp with
# the class, app/systems/NAME.cpp with how its scenes are read and shown, both in the folder FOLDER where IN FOLDER says
# so. What the solvers make of each is compiled once, from files that are made here (systems/instances.hpp).
# INITIAL_VALUES: it is forced, nonholonomic or depends on time, and has no boundary values; others name their sizes
# (solvers/boundary/sizes). REDUCED: how many equations a step has of each reduction that it declares, in their order.
# Further sources of its own stand after SOURCES.
set(system_names)
set(system_classes)
set(system_headers)  # as <lagroid/...>
function(lagroid_system name class)
  cmake_parse_arguments(ARG "INITIAL_VALUES" "IN;SIZES" "REDUCED;SOURCES" ${ARGN})
  set(header systems/${name}.hpp)
  if(ARG_IN)
    set(header systems/${ARG_IN}/${name}.hpp)
  endif()
  set(made ${PROJECT_BINARY_DIR}/systems/${name})
  set(parts steps integrators)
  set(adaptive "")
  if(NOT ARG_INITIAL_VALUES)
    list(APPEND parts adaptive_steps boundary_values varied_steps)
    set(adaptive "LAGROID_ADAPTIVE_STEPS(extern template, ${class});\n")
  endif()
  foreach(part ${parts} certificate)
    configure_file(${PROJECT_SOURCE_DIR}/systems/instances/${part}.cpp.in ${made}_${part}.cpp @ONLY)
  endforeach()
  list(TRANSFORM parts REPLACE "(.+)" "${made}_\\1.cpp" OUTPUT_VARIABLE sources)
  set(place 0)
  set(reduced)
  foreach(variables ${ARG_REDUCED})
    foreach(part steps integrators descent)
      set(file ${made}_reduced_${place}_${part}.cpp)
      configure_file(${PROJECT_SOURCE_DIR}/systems/instances/reduced_${part}.cpp.in ${file} @ONLY)
      list(APPEND sources ${file})
    endforeach()
    string(APPEND reduced "extern template DescentReport examine_reduction(const Reconstruction<${class}, ReductionAt<${class}, ${place}>>&,\n"
           "  const std::vector<ArrowOf<${class}::GroupoidType>>&);\n"
           "using Reduced${class}${place} = ReducedBy<${class}, ${place}>;\n"
           "LAGROID_STEP_SOLVERS(extern template, Reduced${class}${place});\n")
    math(EXPR place "${place}+1")
  endforeach()
  set(system_names ${system_names} ${name} PARENT_SCOPE)
  set(system_headers ${system_headers} ${header} PARENT_SCOPE)
  set(header_of_${name} ${header} PARENT_SCOPE)
  set(system_classes ${system_classes} ${class} PARENT_SCOPE)
  lagroid_part(${name} ${sources} ${ARG_SOURCES})
  set(lagroid_parts ${lagroid_parts} PARENT_SCOPE)
  set(sizes_of_${name} ${ARG_SIZES} PARENT_SCOPE)
  set(reduced_of_${name} ${ARG_REDUCED} PARENT_SCOPE)
  set(reduced_declarations_of_${name} "${reduced}" PARENT_SCOPE)
  set(certificates ${made}_certificate.cpp)
  if(ARG_REDUCED)
    configure_file(${PROJECT_SOURCE_DIR}/systems/instances/reduced_certificate.cpp.in ${made}_reduced_certificate.cpp
                   @ONLY)
    list(APPEND certificates ${made}_reduced_certificate.cpp)
  endif()
  set(certificates_of_${name} ${certificates} PARENT_SCOPE)
endfunction()
lagroid_system(plate_ball PlateBall IN control SIZES 5_3_0 REDUCED 8
               SOURCES systems/control/plate_ball.cpp systems/control/plate_ball_boundary.cpp)
lagroid_system(unicycle Unicycle IN control SIZES 3_2_0)
lagroid_system(attitude_control AttitudeControl IN control SIZES 3_1_0 SOURCES systems/control/attitude_control.cpp)
lagroid_system(rigid_body RigidBody IN rotations SIZES 3_0_0
               SOURCES systems/rotations/rigid_body.cpp systems/rotations/moser_veselov.cpp
                       systems/rotations/moser_veselov_solvers.cpp)
lagroid_system(heavy_top HeavyTop IN rotations SIZES 3_0_0 REDUCED 2
               SOURCES systems/rotations/heavy_top.cpp)
lagroid_system(pendulum Pendulum IN pendulums SIZES 1_0_0)
lagroid_system(kepler Kepler SIZES 2_0_0 REDUCED 2 1)
lagroid_system(spherical_pendulum SphericalPendulum IN pendulums SIZES 3_0_1 SOURCES systems/pendulums/spherical_pendulum.cpp)
lagroid_system(gyrostat Gyrostat IN rotations SIZES 6_0_0_32 REDUCED 3)
lagroid_system(rolling_ball RollingBall IN rolling INITIAL_VALUES REDUCED 7
               SOURCES systems/rolling/rolling_ball.cpp)
lagroid_system(rolling_disk RollingDisk IN rolling INITIAL_VALUES SOURCES systems/rolling/rolling_disk.cpp)
lagroid_system(chaplygin_sleigh ChaplyginSleigh IN rolling INITIAL_VALUES SOURCES systems/rolling/chaplygin_sleigh.cpp)
lagroid_system(damped_pendulum DampedPendulum IN pendulums INITIAL_VALUES SOURCES systems/pendulums/damped_pendulum.cpp)
lagroid_system(driven_pendulum DrivenPendulum IN pendulums INITIAL_VALUES SOURCES systems/pendulums/driven_pendulum.cpp)
lagroid_system(driven_body DrivenBody IN rotations INITIAL_VALUES SOURCES systems/rotations/driven_body.cpp)

# lagroid_for_each_system(variable template): the template once for each system, with NAME, CLASS and HEADER replaced.
function(lagroid_for_each_system variable template)
  set(out)
  foreach(name class header IN ZIP_LISTS system_names system_classes system_headers)
    string(REPLACE HEADER ${header} one "${template}")
    string(REPLACE NAME ${name} one "${one}")
    string(REPLACE CLASS ${class} one "${one}")
    string(APPEND out "${one}")
  endforeach()
  set(${variable} "${out}" PARENT_SCOPE)
endfunction()

# Poisson systems: name, class and header of each, in the order in which they are listed to users. Their integrators are
# compiled once; app/poisson/ has how their scenes are read.
set(poisson_sources)
function(lagroid_poisson_system name class header)
  set(file ${PROJECT_BINARY_DIR}/systems/${name}_poisson_integrators.cpp)
  configure_file(${PROJECT_SOURCE_DIR}/systems/instances/poisson_integrators.cpp.in ${file} @ONLY)
  set(poisson_sources ${poisson_sources} ${file} PARENT_SCOPE)
endfunction()
lagroid_poisson_system(lotka_volterra LotkaVolterra systems/poisson/lotka_volterra.hpp)
lagroid_poisson_system(three_species ThreeSpecies systems/poisson/lotka_volterra.hpp)
lagroid_poisson_system(volterra_ring VolterraRing<5> systems/poisson/lotka_volterra.hpp)
lagroid_poisson_system(euler_top EulerTop systems/poisson/rotations.hpp)
lagroid_poisson_system(kirchhoff Kirchhoff systems/poisson/rotations.hpp)
lagroid_poisson_system(toda OpenToda<4> systems/poisson/lattices.hpp)
lagroid_poisson_system(toda_ring PeriodicToda<3> systems/poisson/lattices.hpp)
lagroid_poisson_system(maxwell_bloch MaxwellBloch systems/poisson/fields.hpp)
lagroid_poisson_system(sklyanin Sklyanin systems/poisson/fields.hpp)
lagroid_poisson_system(magnetic_particle MagneticParticle systems/poisson/fields.hpp)
lagroid_part(poisson ${poisson_sources})
