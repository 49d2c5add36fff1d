# The packages of npm that pages are bundled with, by esbuild: in the folder `packages`.
find_program(ESBUILD esbuild REQUIRED)  # Debian package esbuild

include(FetchContent)
set(packages ${CMAKE_CURRENT_BINARY_DIR}/node_modules)
# lagroid_npm(name version sha512): a package of the npm registry, pinned.
function(lagroid_npm name version sha512)
  string(REGEX REPLACE "^@.*/" "" file ${name})
  string(MAKE_C_IDENTIFIER "npm_${name}" content)
  FetchContent_Declare(${content} URL https://registry.npmjs.org/${name}/-/${file}-${version}.tgz
                       URL_HASH SHA512=${sha512} SOURCE_DIR ${packages}/${name} DOWNLOAD_EXTRACT_TIMESTAMP ON
                       SOURCE_SUBDIR not-for-cmake)
  FetchContent_MakeAvailable(${content})
endfunction()
lagroid_npm(three 0.187.0 422bbb47e0a687c0acb59b18d6e24e4969d595fa3b66d34b57b985f0996d9372c1dc0b43bbd71166572744a90093c638cfa28ac37e73ed8ed4addee3598f1eb4)
lagroid_npm(chart.js 4.5.0 698782fe30e0484c7c487599bc0358322a18319d8a5f4d96e9feae55fcad7ae08671a7432dc6151dd7ddca0b134244384ca9f9960868a2302c3e3e69bb44a7bd)
lagroid_npm(@kurkle/color 0.3.4 3395249d93c746edc31035a88a953ab04f0f76467a67f4bebf8743f8a7bc21a365a5d4906a1e74973d4ab5c1416b6bec74e9f06db9f127054ce30b72eae740e7)
