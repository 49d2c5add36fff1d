#!/usr/bin/env bash
# Installs a build, and uses the installation as a project of its own does: by CMake, by pkg-config, and wrongly.
#   installed_package.sh BUILD WORK [whole]   into folders below WORK; whole: also builds and runs the law suites, and
#                                             compiles every header on its own (minutes)
# A prefix in place of the build (it has no CMakeCache.txt) is used as it is.
set -euo pipefail
build=$1 work=$2 whole=${3:-}
consumer=$(cd "$(dirname "${BASH_SOURCE[0]}")/consumer" && pwd)
say() { printf 'installed_package: %s\n' "$*" >&2; }
fail() {
  say "$*"
  exit 1
}

rm -rf "$work"
mkdir -p "$work"
if [ -e "$build/CMakeCache.txt" ]; then
  prefix=$work/prefix
  cmake --install "$build" --prefix "$prefix" >"$work/install.log" || fail "not installed; see $work/install.log"
else
  prefix=$build
fi
pc=$(find "$prefix" -name lagroid.pc -not -path '*/_CPack_Packages/*' | head -1)
[ -n "$pc" ] || fail "no lagroid.pc below $prefix"
export PKG_CONFIG_PATH=${pc%/*}

# What is installed finds its libraries where the build does.
run_path() { readelf -d "$1" | sed -n 's/.*R.*PATH.*\[\(.*[^:]\):*\]$/\1/p'; }
if [ -e "$build/bin/lagroid" ]; then
  for name in lagroid lagroid-check; do
    [ ! -e "$build/bin/$name" ] || [ "$(run_path "$build/bin/$name")" = "$(run_path "$prefix/bin/$name")" ] ||
      fail "$name looks for libraries in [$(run_path "$prefix/bin/$name")], not in [$(run_path "$build/bin/$name")]"
  done
fi

# A build of the program alone is installed without the Python package; its component is refused.
if grep -qs lagroid_python "$build/build.ninja"; then
  without=$work/without_python
  sed "s|\"$build/python/lagroid/_lagroid|\"$work/missing/_lagroid|" "$build/python/cmake_install.cmake" \
    >"$work/python.cmake"
  cmake -DCMAKE_INSTALL_PREFIX="$without" -P "$work/python.cmake" >"$work/python.log" 2>&1 ||
    { cat "$work/python.log" >&2; fail "without the Python module nothing is installed"; }
  grep -q "Without the Python package: its module is not built" "$work/python.log" || fail "it is missing without a word"
  [ -e "$without/include/lagroid/python/system.hpp" ] || fail "without the module, its headers are missing"
  [ -z "$(find "$without" -name '*.py')" ] || fail "a Python package without its module was installed"
  if cmake -DCMAKE_INSTALL_PREFIX="$without" -DCMAKE_INSTALL_COMPONENT=python -P "$work/python.cmake" \
    2>"$work/python.log"; then
    fail "the component python should have been refused"
  fi
  grep -q "build the target lagroid_python first" "$work/python.log" || fail "refused without saying what to do"
fi

# By CMake. What takes time is at stake in other tests, hence -O1.
cmake -S "$consumer" -B "$work/cmake" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_FLAGS=-O1 \
  >"$work/configure.log" 2>&1 || { cat "$work/configure.log" >&2; fail "find_package(lagroid) does not work"; }
grep -q "^lagroid_DIR:PATH=$prefix" "$work/cmake/CMakeCache.txt" || fail "another lagroid was found than that below $prefix"
cmake --build "$work/cmake" >"$work/build.log" 2>&1 || { cat "$work/build.log" >&2; fail "the consumer is not built"; }
"$work/cmake/compose"
"$work/cmake/spring"
"$work/cmake/old_names" || fail "names of version 0.2 do not make a step"
if [ -e "$prefix/include/lagroid/run/run.hpp" ] && find "$prefix" -name lagroid-run-targets.cmake | grep -q .; then
  "$work/cmake/gyrostat" "$work/gyrostat" >"$work/gyrostat.log" || { cat "$work/gyrostat.log" >&2; fail "the gyrostat breaks a promise"; }
  grep -q "rotor momenta" "$work/gyrostat.log" || fail "the gyrostat has no ledger"
  if [ -x "$prefix/bin/lagroid" ]; then
    "$prefix/bin/lagroid" view "$work/gyrostat" >/dev/null || fail "lagroid view does not show the gyrostat"
    if "$prefix/bin/lagroid" resume "$work/gyrostat" 2>"$work/resume.log"; then fail "lagroid resume went on with it"; fi
    grep -q "start that program again" "$work/resume.log" || fail "lagroid resume does not say who goes on with it"
  fi
fi
if [ -n "$whole" ] && [ -x "$prefix/bin/lagroid" ]; then
  "$prefix/bin/lagroid" new system spring_bob --out "$work/spring_bob" >/dev/null
  sed -i 's/COMPONENTS commands laws/COMPONENTS commands derivatives laws/' "$work/spring_bob/CMakeLists.txt"
  cmake -S "$work/spring_bob" -B "$work/spring_bob/build" -DCMAKE_PREFIX_PATH="$prefix" >"$work/configure.log" 2>&1 ||
    { cat "$work/configure.log" >&2; fail "lagroid_program does not configure"; }
  cmake --build "$work/spring_bob/build" >"$work/build.log" 2>&1 || { cat "$work/build.log" >&2; fail "lagroid_program does not build"; }
  (cd "$work/spring_bob/build" && ctest >"$work/ctest.log" 2>&1) || { cat "$work/ctest.log" >&2; fail "lagroid_program breaks a law"; }
  "$work/spring_bob/build/spring_bob" gradient "$work/spring_bob/spring_bob.toml" --set time.steps=50 --check >"$work/gradient.log" ||
    fail "lagroid_program has no derivatives"
fi
if [ -n "$whole" ]; then
  cmake --build "$work/cmake" --target laws >"$work/build.log" 2>&1 || { cat "$work/build.log" >&2; fail "no laws"; }
  "$work/cmake/laws" 2>/dev/null
fi
if grep -qs '^LAGROID_APP:BOOL=ON' "$build/CMakeCache.txt"; then
  [ -x "$prefix/bin/lagroid" ] || fail "the program is not installed"
fi
if [ -x "$prefix/bin/lagroid" ]; then
  cmake --build "$work/cmake" --target systems >"$work/systems.log" || fail "lagroid::program does not run"
  grep -q rigid_body "$work/systems.log" || fail "lagroid::program lists no rigid_body"
fi

# By pkg-config, with the instruction set of this machine: what the library shares with its callers has one layout.
read -ra flags <<<"$(pkg-config --cflags lagroid)"
read -ra libraries <<<"$(pkg-config --libs lagroid)"
${CXX:-c++} -std=c++20 -O1 -march=native "${flags[@]}" "$consumer/main.cpp" "${libraries[@]}" -o "$work/by_pkg_config"
"$work/by_pkg_config"

# Every header includes what it needs; those of lagroid/python need Python's too.
if [ -n "$whole" ]; then
  (cd "$prefix/include" && find lagroid -name '*.hpp' -not -path 'lagroid/python/*' | sort) >"$work/headers"
  while read -r header; do
    echo "#include <$header>" >"$work/header.cpp"
    ${CXX:-c++} -std=c++20 -fsyntax-only "${flags[@]}" "$work/header.cpp" 2>"$work/header.log" ||
      fail "$header does not compile on its own: $(head -n 3 "$work/header.log")"
  done <"$work/headers"
fi

# Without a build type: told so, and the template for Python sets one.
configured() { # configured SOURCE BUILD ARGUMENTS...
  cmake -S "$1" -B "$work/$2" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_COMPILER_WORKS=1 "${@:3}" >"$work/$2.log" 2>&1 ||
    { cat "$work/$2.log" >&2; fail "$1 is not configured"; }
}
configured "$consumer" no_type -DCMAKE_BUILD_TYPE= -DCMAKE_CXX_FLAGS=
grep -q "no build type is set" "$work/no_type.log" || fail "no build type, and not a word"
configured "$consumer" release -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS=
! grep -q "no build type is set" "$work/release.log" || fail "a false warning of the build type"
template=$prefix/share/lagroid/python/template
if [ -e "$template" ] && [ "$prefix" != "$build" ]; then
  configured "$template" template -DPython_EXECUTABLE=/usr/bin/python3
  ! grep -q "no build type is set" "$work/template.log" || fail "the template has no build type"
  grep -q "^CXX_FLAGS.*-O3" "$work/template/CMakeFiles/my_system.dir/flags.make" || fail "the template is not optimised"
fi

# What must be refused, and why.
refused() { # refused ARGUMENTS-OF-FIND_PACKAGE MESSAGE
  mkdir -p "$work/refused"
  printf 'cmake_minimum_required(VERSION 3.25)\nproject(refused LANGUAGES CXX)\nfind_package(lagroid %s REQUIRED)\n' "$1" \
    >"$work/refused/CMakeLists.txt"
  if cmake -S "$work/refused" -B "$work/refused/build" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_COMPILER_WORKS=1 \
    >"$work/refused.log" 2>&1; then
    fail "find_package(lagroid $1) should have been refused"
  fi
  tr -s ' \n' ' ' <"$work/refused.log" | grep -qF "$2" || { cat "$work/refused.log" >&2; fail "refused without: $2"; }
}
refused "COMPONENTS cores" 'lagroid has no component "cores"; it has core, solvers, systems, run, commands, derivatives, laws and program'
refused "9.0" 'compatible with requested version "9.0"'
refused "0.1" 'compatible with requested version "0.1"'
say "holds"
