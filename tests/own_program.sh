#!/usr/bin/env bash
# A system of one's own from its source: `lagroid new` and `lagroid run SYSTEM.cpp`.
#   own_program.sh LAGROID WORK [whole]   in folders below WORK; whole: also with all methods and with its laws (minutes),
#                                         and every groupoid that is offered
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
lagroid=$1 work=$2 whole=${3:-}
fail() {
  printf 'own_program: %s\n' "$*" >&2
  exit 1
}
rm -rf "$work"
mkdir -p "$work/cache"
cd "$work"
export XDG_CACHE_HOME=$work/cache
programs() { find "$work/cache" -type f -perm -100 | wc -l; }

# A folder to begin with runs as it stands, and is compiled once.
"$lagroid" new system spring_bob >new.log
"$lagroid" run spring_bob/spring_bob.cpp --json >first.json 2>first.log || { cat first.log >&2; fail "it does not run"; }
grep -q '"status": "converged"' first.json || fail "it did not converge"
grep -q 'discrete energy E_d' first.json || fail "no energy in its ledger"
! grep -q BROKEN first.json || fail "it breaks a promise"
[ "$(programs)" -eq 1 ] || fail "$(programs) programs in the cache after one"
"$lagroid" run spring_bob/spring_bob.cpp spring_bob/spring_bob.toml --set parameters.stiffness=2 --out out >again.log
[ "$(programs)" -eq 1 ] || fail "compiled again without a change"
"$lagroid" view out >/dev/null || fail "lagroid view does not show its run"
"$lagroid" run spring_bob/spring_bob.cpp resume out --set time.steps=2100 >/dev/null || fail "its run is not taken up"
"$lagroid" run spring_bob/spring_bob.cpp list >list.log
grep -q 'stiffness' list.log || fail "its parameters are not listed"
"$lagroid" run spring_bob/spring_bob.cpp schema spring_bob >schema.json || fail "it has no schema"
/usr/bin/python3 - <<'PYTHON' || fail "its scene is not what its schema says"
import json, tomllib
import jsonschema
scene = tomllib.load(open("spring_bob/spring_bob.toml", "rb"))
validator = jsonschema.Draft202012Validator(json.load(open("schema.json")))
validator.validate(scene)
scene["parameters"]["stifness"] = 2
assert not validator.is_valid(scene)
PYTHON
sed -i 's/time.step/time.step/; s/return twice \* 0.5/return twice * 0.25/' spring_bob/spring_bob.cpp
"$lagroid" run spring_bob/spring_bob.cpp >/dev/null 2>&1 || fail "a change does not compile"
[ "$(programs)" -eq 2 ] || fail "a change was not compiled"

# The same of a Poisson bracket, with every method and its laws from one program each.
"$lagroid" new bracket my_levels >new.log
"$lagroid" run my_levels/my_levels.cpp --json >bracket.json 2>bracket.log || { cat bracket.log >&2; fail "the bracket does not run"; }
grep -q '"status": "converged"' bracket.json || fail "the bracket's run did not converge"
! grep -q BROKEN bracket.json || fail "the bracket's run breaks a promise"
"$lagroid" run my_levels/my_levels.cpp my_levels/my_levels.toml --set time.method=hamilton-jacobi-4 --set time.steps=50 >methods.log || fail "the bracket has no other method"
"$lagroid" run my_levels/my_levels.cpp list >list.log
grep -q 'stretch' list.log || fail "the bracket's parameters are not listed"

# What is wrong is told in a line, with an exit code, and leaves nothing.
refused() { # refused CODE WORDS ARGUMENTS...
  local code=0
  "$lagroid" "${@:3}" >refused.out 2>refused.log || code=$?
  [ "$code" -eq "$1" ] || { cat refused.log >&2; fail "${*:3}: exit code $code, not $1"; }
  grep -qF -- "$2" refused.log || { cat refused.log >&2; fail "${*:3}: not told: $2"; }
}
refused 2 "is no name" new system 'Spring; rm -rf'
refused 2 "is there already" new system spring_bob
refused 2 "give another name, as in my_state" new system state
refused 2 "groupoid" new system other --groupoid sl7
refused 2 "no such file" run nothing.cpp
refused 2 "unknown" run spring_bob/spring_bob.cpp --set parameters.stifness=2
[ ! -e other ] || fail "a folder was left"
sed 's/return lagrangian(g, h)/return lagrangian(g, hh)/' spring_bob/spring_bob.cpp >wrong.cpp
refused 2 "does not compile" run wrong.cpp
sed -n 3p refused.log | grep -q "wrong.cpp.*error.*hh" || { cat refused.log >&2; fail "the user's line is not the first"; }
sed 's|^  // Constraints psi.*|  int symmetries() const { return 0; }|' spring_bob/spring_bob.cpp >misfit.cpp
refused 2 "does not compile" run misfit.cpp
sed -n 3p refused.log | grep -q "symmetries" || { cat refused.log >&2; fail "the requirement is not told first"; }

# A cache that others can write in is not used.
chmod 770 "$work/cache/lagroid"
refused 2 "nobody else may enter" run spring_bob/spring_bob.cpp
chmod 700 "$work/cache/lagroid"
mv "$work/cache/lagroid" "$work/elsewhere"
ln -s "$work/elsewhere" "$work/cache/lagroid"
refused 2 "nobody else may enter" run spring_bob/spring_bob.cpp
rm "$work/cache/lagroid"

if [ -n "$whole" ]; then
  "$lagroid" run spring_bob/spring_bob.cpp --set time.mode=adaptive >adaptive.log 2>&1 || { cat adaptive.log >&2; fail "no adaptive steps"; }
  "$lagroid" run spring_bob/spring_bob.cpp study spring_bob/spring_bob.toml --out study >/dev/null || fail "no study"
  "$lagroid" run spring_bob/spring_bob.cpp check spring_bob/spring_bob.toml >check.log 2>&1 || { cat check.log >&2; fail "its laws do not hold"; }
  for groupoid in so3 so2 se2 vector; do
    "$lagroid" new system "on_$groupoid" --groupoid "$groupoid" >/dev/null
    "$lagroid" run "on_$groupoid/on_$groupoid.cpp" >run.log 2>&1 || { cat run.log >&2; fail "the system on $groupoid does not run"; }
    ! grep -q BROKEN run.log || fail "the system on $groupoid breaks a promise"
  done
  "$lagroid" run my_levels/my_levels.cpp study my_levels/my_levels.toml --out levels >/dev/null || fail "no study of the bracket"
  "$lagroid" run my_levels/my_levels.cpp check my_levels/my_levels.toml >check.log 2>&1 || { cat check.log >&2; fail "the bracket's laws do not hold"; }
  sed 's/{0, 2, -x(1)}/{0, 2, x(0)}/' my_levels/my_levels.cpp >no_bracket.cpp
  ! "$lagroid" run no_bracket.cpp my_levels/my_levels.toml >check.log 2>&1 || fail "a bracket that is none runs"
  grep -q Jacobi check.log || { cat check.log >&2; fail "the broken identity is not named"; }
  # Derivatives of its runs, by all of its numbers, and of its bracket's; its own numbers back from its data.
  "$lagroid" run spring_bob/spring_bob.cpp gradient spring_bob/spring_bob.toml --set time.steps=50 --check --json >gradient.json 2>gradient.log || { cat gradient.log >&2; fail "its runs have no derivatives"; }
  "$lagroid" run spring_bob/spring_bob.cpp spring_bob/spring_bob.toml --set parameters.stiffness=2 --set time.steps=100 --out measured >run.log
  "$lagroid" run spring_bob/spring_bob.cpp fit spring_bob/spring_bob.toml measured/trajectory.csv --wrt parameters.stiffness --json >fit.json 2>fit.log || { cat fit.log >&2; fail "its numbers are not fitted"; }
  "$lagroid" run my_levels/my_levels.cpp gradient my_levels/my_levels.toml --set time.steps=50 --check --json >levels.json 2>gradient.log || { cat gradient.log >&2; fail "the bracket's runs have no derivatives"; }
  /usr/bin/python3 - <<'PYTHON' || fail "its derivatives are not those of its runs"
import json
for file, number in ("gradient.json", "parameters.stiffness"), ("levels.json", "parameters.stretch"):
    found = json.load(open(file))
    assert number in found["by"] and found["digits_agreed"] > 7 and not found["contradicted"], found
assert abs(json.load(open("fit.json"))["unknowns"][0]["value"] - 2) < 1e-9
PYTHON
  "$lagroid" new groupoid hills >/dev/null
  "$lagroid" run hills/on_hills.cpp >run.log 2>&1 || { cat run.log >&2; fail "the groupoid does not run"; }
  "$lagroid" run hills/on_hills.cpp check hills/on_hills.toml >check.log 2>&1 || { cat check.log >&2; fail "the laws of the groupoid do not hold"; }
  sed -i 's/g(2) + h(2)}/g(2) + h(2) * 2.0}/' hills/hills.hpp
  ! "$lagroid" run hills/on_hills.cpp check hills/on_hills.toml --set time.steps=20 >check.log 2>&1 || fail "a broken groupoid passes"
  grep -q associat check.log || { cat check.log >&2; fail "its broken law is not named"; }
  # Steps that fail do not hide it.
  ! "$lagroid" run hills/on_hills.cpp check hills/on_hills.toml --set time.step=1e9 >check.log 2>&1 || fail "a failed run passes"
  grep -q "groupoid is none: units is broken" check.log || { cat check.log >&2; fail "its broken law is not named beside the failure"; }

  # A system that declares reductions runs reduced from a scene: the full motion comes back, and the laws are those of
  # what it is reduced to.
  cp "$here/app/own_reduced/"* .
  "$lagroid" run bob.cpp --out full >run.log 2>&1 || { cat run.log >&2; fail "the bob does not run"; }
  "$lagroid" run bob.cpp list >list.log
  grep -q 'reduced by  *angular-momentum' list.log || fail "its reductions are not listed"
  for by in rotations angular-momentum; do
    "$lagroid" run bob.cpp --set "reduce=$by" --out "$by" >run.log 2>&1 || { cat run.log >&2; fail "the bob reduced by $by does not run"; }
    ! grep -q BROKEN run.log || { cat run.log >&2; fail "the bob reduced by $by breaks a promise"; }
    /usr/bin/python3 - full "$by" <<'PYTHON' || fail "reduced by $by it is not the full motion"
import csv, sys
def rows(folder):
    with open(f"{folder}/trajectory.csv") as file:
        return list(csv.DictReader(line.lstrip("# ") for line in file))
full, back = map(rows, sys.argv[1:])
assert len(full) == len(back) == 1001 and len(back[0]) > len(full[0])
for a, b in zip(full, back):
    for name in a:
        if a[name]: assert abs(float(a[name]) - float(b[name])) <= 1e-10 * (1 + abs(float(a[name]))), (name, a, b)
PYTHON
    "$lagroid" run bob.cpp check bob.toml --samples 20 --set "reduce=$by" >check.log 2>&1 || { cat check.log >&2; fail "laws of the bob reduced by $by do not hold"; }
    grep -q 'reduced: derivatives' check.log || { cat check.log >&2; fail "the bob reduced by $by is asked no laws"; }
  done
  grep -q 'reduced: momentum level' check.log || { cat check.log >&2; fail "its momentum level is asked no laws"; }
  refused 2 '"rotations" is no symmetry of this system: the Lagrangian does not descend: at the arrow' \
    run bob.cpp --set reduce=rotations --set parameters.wind=0.1
  refused 2 '"translations" is none of rotations, angular-momentum' run bob.cpp --set reduce=translations
fi
echo "own_program: holds"
