# Answers find_package for a browser: libraries that are headers, which Debian's packages for this machine hold too. They
# are seen through links in one folder, for /usr/include itself has this machine's C library. Others are not there.
set(lagroid_web_headers ${CMAKE_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${lagroid_web_headers})
foreach(folder boost CLI fmt nlohmann Random123 Spectra toml++ xsimd)
  file(CREATE_LINK /usr/include/${folder} ${lagroid_web_headers}/${folder} SYMBOLIC)
endforeach()
file(CREATE_LINK /usr/include/eigen3 ${lagroid_web_headers}/eigen3 SYMBOLIC)
set(LAGROID_RANDOM123 ${lagroid_web_headers} CACHE PATH "Random123, the generator of noise")

# lagroid_web_package(method name): as find_package calls it.
macro(lagroid_web_package method name)
  set(${name}_FOUND FALSE)
  foreach(package target folder IN ZIP_LISTS lagroid_web_packages lagroid_web_targets lagroid_web_folders)
    if(package STREQUAL "${name}")
      set(${name}_FOUND TRUE)
      if(NOT TARGET ${target})
        add_library(${target} INTERFACE IMPORTED GLOBAL)
        target_include_directories(${target} SYSTEM INTERFACE ${folder})
      endif()
    endif()
  endforeach()
endmacro()
set(lagroid_web_packages Boost CLI11 Eigen3 fmt nlohmann_json Spectra tomlplusplus xsimd)
set(lagroid_web_targets Boost::headers CLI11::CLI11 Eigen3::Eigen fmt::fmt nlohmann_json::nlohmann_json Spectra::Spectra
                        tomlplusplus::tomlplusplus xsimd)
set(lagroid_web_folders ${lagroid_web_headers} ${lagroid_web_headers} ${lagroid_web_headers}/eigen3 ${lagroid_web_headers}
                        ${lagroid_web_headers} ${lagroid_web_headers} ${lagroid_web_headers} ${lagroid_web_headers})
cmake_language(SET_DEPENDENCY_PROVIDER lagroid_web_package SUPPORTED_METHODS FIND_PACKAGE)
