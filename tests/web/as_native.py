#!/usr/bin/python3
"""Scenes in WebAssembly end where those of the program end, up to what round-off grows to, with the same verdicts.

as_native.py LAGROID GLUE EXAMPLES
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import tomllib
import unittest

LAGROID, GLUE, EXAMPLES = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
RUN = pathlib.Path(__file__).with_name("run_scene.mjs")

# A motion that a share of 1e-9 leads so far away grows roundings beyond what can be foretold.
FORGOTTEN = 1e-4
# All examples but those of systems that the page has not, those that read files, and one that takes its time.
NOT_THERE = {"gyrostat", "driven_body", "learned_hamiltonian", "pythagorean"}
SCENES = sorted(path.stem for path in EXAMPLES.glob("*.toml") if path.stem not in NOT_THERE)


def changes(scene):
    """The start, or the end to be reached, with one number changed by a small share, and that share of the number; where
    steps adapt, or the start is no list of free numbers, the step too."""
    text = tomllib.loads((EXAMPLES / f"{scene}.toml").read_text())
    share = 1e-9
    table = "boundary.end" if "boundary" in text else "initial"
    start = text["boundary"]["end"] if "boundary" in text else text.get("initial", {})
    # A number that is not zero, and a key that takes any numbers.
    key = next((key for key in ("state", "momentum", "velocity", "position") if any(start.get(key, []))), None)
    if key:
        at = next(i for i, value in enumerate(start[key]) if value)
        changed = [value * (1 + share) if i == at else value for i, value in enumerate(start[key])]
        yield f"{table}.{key}={changed}", share * abs(start[key][at])
    if not key or text["time"].get("mode") == "adaptive":
        name = "step" if "step" in text["time"] else "duration"
        yield f"time.{name}={text['time'][name] * (1 + share)}", share * text["time"][name]


def native(scene, settings=()):
    words = [word for setting in settings for word in ("--set", setting)]
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([LAGROID, "run", EXAMPLES / f"{scene}.toml", *words, "--out", f"{folder}/run"], check=False,
                       capture_output=True)
        return json.loads((pathlib.Path(folder) / "run/summary.json").read_text())


def compiled(scene, *words):
    run = subprocess.run(["node", RUN, GLUE, EXAMPLES / f"{scene}.toml", *words], capture_output=True, text=True,
                         check=False)
    assert run.returncode == 0, run.stderr
    return json.loads(run.stdout)


def numbers(summary):
    end = summary["final"]
    return [*end.get("position", []), *end.get("attitude", []), *end.get("momentum", [])]


def apart(one, other):
    return max(abs(a - b) for a, b in zip(numbers(one), numbers(other), strict=True))


def as_far_as_it_can_be_told(scene):
    """The settings with which a small change of the start is still a small one at the end, and what it has grown by: of a
    chaotic motion, fewer steps."""
    steps = []
    while True:
        end = native(scene, steps)
        changed = [(apart(end, native(scene, [*steps, change])), size) for change, size in changes(scene)]
        if end["steps"] < 100 or max((off for off, _ in changed), default=0) < 1e-3 * max(map(abs, numbers(end))):
            return steps, max([1.0, *(off / size for off, size in changed)])
        steps = [f"time.steps={end['steps'] // 2}"]


class AsNative(unittest.TestCase):
    def test_ends_and_verdicts(self):
        for scene in SCENES:
            with self.subTest(scene):
                steps, growth = as_far_as_it_can_be_told(scene)
                ours, theirs = compiled(scene, *steps), native(scene, steps)
                self.assertEqual(ours["status"], theirs["status"])
                self.assertEqual(ours["steps"], theirs["steps"])
                verdicts = [{entry["name"]: entry["verdict"] for entry in run["ledger"]["entries"]}
                            for run in (ours, theirs)]
                self.assertEqual(*verdicts)
                largest = max(map(abs, numbers(theirs)))
                # A random walk of roundings, each made larger by as much as the motion does with a difference at the start;
                # steps that adapt are roots of an equation of small differences, in which a rounding weighs more, and so it
                # does in a body's path between two attitudes, one of all steps at once.
                weight = 200 if "adaptive" in scene or scene == "rigid_body_boundary" else 20
                bound = 2**-53 * largest * growth * weight * (10 + math.sqrt(theirs["steps"]))
                off = apart(ours, theirs)
                print(f"{scene}: off by {off:.2g}, allowed {bound:.2g}", file=sys.stderr)
                self.assertLess(off, bound)

    def test_mistakes_are_told_with_their_line(self):
        with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
            file.write('system = "pendulum"\n[time]\nstep = 0.1\nsteps = "many"\n')
            file.flush()
            run = subprocess.run(["node", RUN, GLUE, file.name], capture_output=True, text=True, check=False)
        self.assertNotEqual(run.returncode, 0)
        self.assertIn("scene:4: time.steps", run.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
