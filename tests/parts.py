#!/usr/bin/env python3
"""What `./lagroid` builds for a scene, and that it does what the whole program does: parts.py BIN EXAMPLES.

BIN holds lagroid, lagroid-part and parts/pendulum, parts/bodies, parts/spheres, parts/poisson
and parts/files.
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

bin_folder, examples = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
built = ("pendulum", "bodies", "spheres", "poisson", "files")


def run(program, *words):
    return subprocess.run([str(program), *map(str, words)], capture_output=True, text=True, timeout=120)


def part_of(*words):
    told = run(bin_folder / "lagroid-part", *words)
    assert told.returncode == 0, told.stderr
    return told.stdout.strip()


def of_part(name):
    return bin_folder / "parts" / name / "lagroid"


def without_times(text):
    result = json.loads(text)
    return {key: value for key, value in result.items() if key not in ("seconds", "program", "machine")}


class Parts(unittest.TestCase):
    def test_every_example_has_one(self):
        listed = {system["name"] for system in json.loads(run(bin_folder / "lagroid", "list", "--json").stdout)}
        found = {scene: part_of("run", scene) for scene in sorted(examples.rglob("*.toml"))}
        self.assertGreater(len(found), 40)
        for scene, part in found.items():
            self.assertTrue(part in listed or part in ("bodies", "spheres", "poisson", "whole"), f"{scene}: {part}")
        self.assertEqual({"pendulum", "bodies", "spheres", "poisson", "whole"} - set(found.values()), set())

    def test_they_give_what_the_whole_gives(self):
        for scene in sorted(examples.glob("*.toml")):
            part = part_of("run", scene)
            if part not in built:
                continue
            words = ("run", scene, "--json", "--set", "time.steps=20")
            whole, alone = run(bin_folder / "lagroid", *words), run(of_part(part), *words)
            self.assertEqual(whole.returncode, alone.returncode, f"{scene}: {alone.stderr}")
            self.assertEqual(without_times(whole.stdout), without_times(alone.stdout), str(scene))

    def test_gradients_are_those_of_the_run(self):
        scene = ("gradient", examples / "pendulum.toml", "--set", "time.steps=50")
        told = run(of_part("pendulum"), *scene, "--of", "final.position,final.momentum", "--check", "--json")
        self.assertEqual(told.returncode, 0, told.stderr)
        found = json.loads(told.stdout)
        self.assertEqual(found["by"][2:], ["parameters.mass", "parameters.length", "parameters.gravity"])
        (a, b), (c, d) = (row[:2] for row in found["derivatives"])
        self.assertAlmostEqual(a * d - b * c, 1, delta=1e-12)
        self.assertGreater(found["digits_agreed"], 8)
        table = run(of_part("pendulum"), *scene, "--of", "integral.position,node.3.momentum", "--wrt",
                    "parameters.length")
        self.assertIn("by parameters.length", table.stdout)
        self.assertIn("digits", table.stdout)

    def test_errors_become_what_those_of_runs_that_are_drawn_become(self):
        told = run(of_part("pendulum"), "gradient", examples / "pendulum.toml", "--set", "time.steps=50", "--of", "final",
                   "--deviations", "initial.momentum=0.02,parameters.length=0.01", "--draws", "4000", "--seed", "5",
                   "--json")
        self.assertEqual(told.returncode, 0, told.stderr)
        found = json.loads(told.stdout)
        self.assertEqual(found["by"], ["initial.p", "parameters.length"])
        derivatives, covariance = found["derivatives"], found["covariance"]
        for i in range(2):
            for k in range(2):
                wanted = sum(derivatives[i][j] * derivatives[k][j] * s * s for j, s in enumerate([0.02, 0.01]))
                self.assertAlmostEqual(covariance[i][k], wanted, delta=1e-12 * abs(wanted) + 1e-18)
        drawn = found["draws"]
        self.assertEqual((drawn["runs"], drawn["failed"]), (4000, 0))
        # Variances of n draws are off by a share sqrt(2 / (n - 1)), 2.2 %, and by what is not linear.
        for i in range(2):
            self.assertAlmostEqual(drawn["covariance"][i][i] / covariance[i][i], 1, delta=0.09)
            self.assertAlmostEqual(drawn["mean"][i], found["values"][i], delta=5 * (covariance[i][i] / 4000) ** 0.5 + 2e-3)
        table = run(of_part("pendulum"), "gradient", examples / "pendulum.toml", "--set", "time.steps=50",
                    "--deviations", "initial.momentum=0.02")
        self.assertIn("% by initial.p", table.stdout)
        self.assertIn("correlations", table.stdout)

    def test_gradients_that_there_are_not_are_refused_in_a_line(self):
        for words, said in {
            ("--deviations", "initial.momentum"): "give NAME=SIGMA, a positive standard deviation",
            ("--deviations", "initial.momentum=-1"): "give NAME=SIGMA, a positive standard deviation",
            ("--deviations", "initial=1,initial.momentum=1"): "has two deviations",
            ("--deviations", "mass=1"): "initial.NAME or parameters.NAME",
            ("--of", "final.energy"): "nothing of that name is differentiable",
            ("--of", "node.51.position"): "a node is a number from 0 to 50",
            ("--of", "energy"): "ask for final.NAME",
            ("--wrt", "parameters.quadrature"): "nothing of that name is differentiable",
            ("--wrt", "mass"): "initial.NAME or parameters.NAME",
            ("--set", "time.mode=adaptive"): "equal steps of order two",
            ("--set", "time.order=4"): "equal steps of order two",
        }.items():
            told = run(of_part("pendulum"), "gradient", examples / "pendulum.toml", "--set", "time.steps=50", *words)
            self.assertEqual(told.returncode, 2, f"{words}: {told.stdout}")
            self.assertEqual(len(told.stderr.splitlines()), 1, told.stderr)
            self.assertIn(said, told.stderr)

    def test_a_folder_needs_no_scene(self):
        self.assertEqual(part_of("view", "out"), "files")
        self.assertEqual(part_of("list"), "whole")
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "out"
            self.assertEqual(run(of_part("pendulum"), "run", examples / "pendulum.toml", "--out", out).returncode, 0)
            self.assertEqual(part_of("resume", out), "pendulum")
            self.assertEqual(run(of_part("files"), "view", out).returncode, 0)

    def test_scenes_of_others_are_refused(self):
        told = run(of_part("pendulum"), "run", examples / "kepler.toml")
        self.assertEqual(told.returncode, 2)
        self.assertIn("kepler", told.stderr)
        self.assertEqual(run(bin_folder / "lagroid-part", "run", pathlib.Path(__file__)).returncode, 2)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
