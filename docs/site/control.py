"""Writes docs/optimal_control_measured.md: control.py TESTS runs the tests of optimal control, programs in the folder TESTS,
and tells what they recorded."""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

root = pathlib.Path(__file__).resolve().parents[2]

page = """<!-- Written by `./lagroid pages control`. -->
# What optimal control reaches

What tests of [optimal control](optimal_control.md) found, which hold costs, lengths, words, shares of what is solved and iterations of
samples to bounds; they ran by

    ./lagroid pages control

which writes this page. Times and iterations beside IPOPT's are in [what a step costs](performance.md).

## Costs beside references

Costs of 100, 200 and 400 stages less those of shooting and collocation. C is what a plain midpoint rule of the references' own
makes of it, at most C / N²; ours are to be within five times that and 1e-6, and, where nothing switches, of order two.

| problem | C | N = 100 | N = 200 | N = 400 |
|---|---|---|---|---|
{errors}

Cars beside the lengths of Dubins and, where they go both ways, of Reeds and Shepp, and the words that were found, but for pieces of one
stage: on 800 and on 400 stages. Where a way turns at the full rate throughout, many may be as short.

| | length | ours less that | word |
|---|---|---|---|
{ways}

## Problems drawn at random

Between states that random admissible controls join, 50 stages, at most ten starts of at most 150 iterations.

| | solved | from the first start | iterations, in the median | the others ended |
|---|---|---|---|---|
{instances}

## A sample of a control loop

A satellite that turns beside a cone with bounded torques, 50 stages, and is pushed about: {samples} samples, each a solve to the tolerance
from the last plan. Times are those of one machine, busy with what else it does.

| of the samples | iterations at most | time at most |
|---|---|---|
{percentiles}
"""


def recorded(program):
    """What the tests of a program recorded: {name: {key: value}}."""
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder) / "report.json"
        done = subprocess.run([program, f"--gtest_output=json:{report}"], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"control.py: {program} failed\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
        suites = json.loads(report.read_text())["testsuites"]
    return {f"{test['classname']}.{test['name']}": test for suite in suites for test in suite["testsuite"]}


def in_words(name):
    """"OfTheDoubleIntegrator" as "of the double integrator"; who is named keeps the capital."""
    words = re.sub(r"(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", " ", name).split()
    return " ".join(word if word in ("Dubins", "Reeds", "Shepp") else word.lower() for word in words)


def error_rows(tests):
    for test, properties in tests.items():
        for key, value in properties.items():
            if not key.startswith("errors of "):
                continue
            constant, *errors = map(float, value.split())
            cells = " | ".join(f"{x:.2g}" for x in errors)
            yield f"| `{test}`, {key.removeprefix('errors of ')} | {constant:.3g} | {cells} |"


def way_rows(tests):
    for name, test in (("Dubins", "DubinsCars.FindTheWordsOfTheShortestWays"),
                       ("Reeds and Shepp", "ReedsSheppCars.FindTheShortestWaysAndTheirWords")):
        for key, value in tests[test].items():
            if key.startswith("length "):
                number = key.removeprefix("length ")
                length, ours = map(float, value.split())
                yield f"| {name} {number} | {length:.6f} | {ours - length:.1g} | {tests[test][f'word {number}']} |"


def instance_rows(tests):
    for test, found in tests.items():
        ended = ", ".join(f"{key.removeprefix('ended ')} {value}" for key, value in found.items() if key.startswith("ended "))
        yield (f"| {in_words(test.split('.')[1])} | {found['solved']} of {found['instances']} | {found['at_once']} "
               f"| {found['iterations']} | {ended or 'none did'} |")


def percentile_rows(loop):
    for key, value in loop.items():
        if key.startswith("percentile "):
            iterations, seconds = value.split()
            yield f"| {key.removeprefix('percentile ')} % | {iterations} | {1e3 * float(seconds):.2g} ms |"


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: control.py TESTS")
    programs = pathlib.Path(sys.argv[1]).resolve()
    solved = recorded(programs / "optimal_control")
    loop = recorded(programs / "optimal_control_long_loop")["LongControlLoops.HardlyASampleTakesManyIterations"]
    written = page.format(errors="\n".join(error_rows(solved)), ways="\n".join(way_rows(solved)),
                          instances="\n".join(instance_rows(recorded(programs / "optimal_control_instances"))),
                          samples=loop["samples"], percentiles="\n".join(percentile_rows(loop)))
    partial = root / "docs/optimal_control_measured.md.partial-page"
    partial.write_text(written)
    os.replace(partial, root / "docs/optimal_control_measured.md")


if __name__ == "__main__":
    main()
