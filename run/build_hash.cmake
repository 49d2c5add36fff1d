# Writes FOLDER/build_hash.cpp: a hash of the sources that FOLDER/sources.txt lists (below ROOT), of FOLDER/build.txt,
# and of what COMPILER takes ARCH for on this machine.
if(COMPILER_ID STREQUAL "GNU")
  set(question -Q --help=target)
else()
  set(question -\#\#\# -c -x c++ /dev/null)  # clang's, with the processor and its features
endif()
if(ARCH)
  list(PREPEND question -march=${ARCH})
endif()
execute_process(COMMAND ${COMPILER} ${question} OUTPUT_VARIABLE target ERROR_VARIABLE target_of_clang
                RESULT_VARIABLE failed WORKING_DIRECTORY /)
if(failed)
  message(FATAL_ERROR "${COMPILER} ${question}: ${target_of_clang}")
endif()
file(READ ${FOLDER}/build.txt all)
string(APPEND all "${target}${target_of_clang}")
file(STRINGS ${FOLDER}/sources.txt sources)
foreach(source ${sources})
  file(SHA256 ${source} sum)
  file(RELATIVE_PATH name ${ROOT} ${source})
  string(APPEND all "${name} ${sum}\n")
endforeach()
string(SHA256 hash "${all}")
string(SUBSTRING ${hash} 0 12 hash)
file(WRITE ${FOLDER}/build_hash.cpp
"#include \"machine.hpp\"\n
namespace lagroid {\n
const char* build_hash() { return \"${hash}\"; }\n
}  // namespace lagroid\n")
