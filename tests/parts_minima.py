#!/usr/bin/env python3
"""`lagroid gradient` of scenes of `lagroid optimize`: parts_minima.py BIN EXAMPLES, as parts.py."""
import json
import math
import pathlib
import sys
import tempfile
import unittest

from parts import examples, of_part, part_of, run

folder_of_examples = examples / "optimisation"


class Minima(unittest.TestCase):
    def told(self, scene, *words, code=0):
        told = run(of_part("optimisation"), "gradient", folder_of_examples / f"{scene}.toml", *words)
        self.assertEqual(told.returncode, code, told.stderr + told.stdout)
        return told

    def found(self, scene, *words, code=0):
        return json.loads(self.told(scene, *words, "--json", code=code).stdout)

    def refused(self, why, scene, *words, code=2):
        told = self.told(scene, *words, code=code)
        self.assertEqual(len(told.stderr.splitlines()), 1, told.stderr)
        self.assertIn(why, told.stderr)
        self.assertEqual(told.stdout, "")

    def test_a_part_has_them(self):
        self.assertEqual(part_of("gradient", folder_of_examples / "membrane.toml"), "optimisation")
        self.assertEqual(part_of("run", folder_of_examples / "membrane.toml"), "whole")

    def test_weights_weigh_eigenvalues(self):
        found = self.found("membrane", "--of", "minimum", "--wrt", "parameters.weights", "--check")
        self.assertEqual((found["outcome"], found["of"]), ("not_strict", ["minimum"]))
        self.assertIn("the minimum is not strict", found["notes"][-1])
        self.assertGreater(found["digits_agreed"], 8)
        # Of the five-point Laplacian of 12 x 12 inner nodes.
        of_axis = [2 - 2 * math.cos(k * math.pi / 13) for k in range(1, 13)]
        least = sorted(a + b for a in of_axis for b in of_axis)[:5]
        for number, exact in zip(found["derivatives"][0], reversed(least)):
            self.assertAlmostEqual(number, exact, delta=1e-12)
        text = self.told("membrane", "--wrt", "parameters.weights").stdout
        self.assertRegex(text, r"by parameters.weights.4 +0.1162\d+|by parameters.weights.4")
        self.assertIn("note: the minimum is not strict", text)

    def test_what_has_no_derivative_is_told_in_one_line(self):
        self.refused("the minimum is not strict", "membrane", "--of", "minimiser", "--wrt", "parameters.weights", code=3)
        self.refused("the least value has none either", "membrane", "--of", "minimum", "--wrt", "data.A.0.1", code=3)
        self.assertEqual(self.found("membrane", "--of", "minimiser", "--wrt", "parameters", code=3)["outcome"], "not_strict")

    def test_they_are_what_differences_tend_to(self):
        for scene, *words in (("markers", "--of", "minimum,minimiser", "--wrt", "data.A.2,data.B.0"),
                              ("tensors", "--of", "minimum,minimiser"),
                              ("hyperbolic_mean", "--of", "minimum,minimiser"),
                              ("rayleigh", "--of", "minimum,minimiser.0,minimiser.7", "--wrt", "data.A.3.4,data.A.5.5")):
            found = self.found(scene, *words, "--check")
            self.assertEqual((found["outcome"], found["contradicted"], found["untold"]), ("strict", [], []), scene)
            self.assertGreater(found["digits_agreed"], 7, scene)
            self.assertGreater(found["digits_of_minimum"], 12, scene)
            self.assertGreater(found["digits_of_minimiser"], 10, scene)

    def test_numbers_are_called_by_their_places(self):
        self.assertEqual(self.found("tensors", "--wrt", "data.matrices.5.1")["by"], ["data.matrices.4.2"])
        self.assertEqual(self.found("tensors")["by"][:4],
                         ["data.matrices.0.0", "data.matrices.0.1", "data.matrices.0.2", "data.matrices.1.1"])
        self.assertEqual(len(self.found("tensors")["by"]), 30)
        self.assertEqual(self.found("hyperbolic_mean", "--wrt", "data.points.1")["by"], ["data.points.1.0", "data.points.1.1"])
        found = self.found("rayleigh", "--wrt", "data.A.4.3,data.A.3.4")
        self.assertEqual(found["by"], ["data.A.3.4"])
        self.assertEqual(len(self.found("markers", "--of", "minimiser")["of"]), 9)
        self.assertIn("are left out", self.found("membrane")["notes"][0])

    def test_what_cannot_be_asked_is_refused_in_one_line(self):
        self.refused("ask for minimum, minimiser or one number of it, as minimiser.2.2", "markers", "--of", "final.position")
        self.refused("minimiser.2.3: ask for", "markers", "--of", "minimiser.2.3")
        self.refused("data.A.200.0: no number of that name", "rayleigh", "--wrt", "data.A.200.0")
        self.refused("initial: no number of that name", "rayleigh", "--wrt", "initial")
        self.refused("ask for them by name, as data.A.0.0", "rayleigh")
        self.refused("--column: is of runs", "markers", "--column", "a=1")
        self.refused("--deviations: is of runs", "markers", "--deviations", "data.A.0.0=1")
        self.refused("the minimum of a penalty", "membrane", "--set", "method.constraint=penalty", "--set", "reference=false")
        told = run(of_part("optimisation"), "fit", folder_of_examples / "markers.toml", folder_of_examples / "data/markers.csv")
        self.assertEqual((told.returncode, len(told.stderr.splitlines())), (2, 1), told.stderr)
        self.assertIn("is no motion", told.stderr)
        told = run(of_part("pendulum"), "gradient", folder_of_examples / "markers.toml")
        self.assertEqual((told.returncode, len(told.stderr.splitlines())), (2, 1), told.stderr)
        self.assertIn("this program has no derivatives of minima", told.stderr)

    def test_a_minimisation_that_fails_is_told(self):
        self.refused("iterations did not suffice", "markers", "--set", "stop.iterations=1", code=3)
        found = self.found("markers", "--set", "stop.iterations=1", code=3)
        self.assertEqual((found["status"], found["outcome"], "derivatives" in found), ("failed", "iteration_limit", False))
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder) / "scene.toml"
            (pathlib.Path(folder) / "a.csv").write_text("2, 0\n0, 2\n")
            scene.write_text('problem = "rayleigh"\n[data]\nA = "a.csv"\n')
            told = run(of_part("optimisation"), "gradient", scene, "--of", "minimiser")
            self.assertEqual((told.returncode, len(told.stderr.splitlines())), (3, 1), told.stderr + told.stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
