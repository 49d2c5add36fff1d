#!/usr/bin/env python3
"""`lagroid gradient` of scenes of `lagroid optimize`: parts_minima.py BIN EXAMPLES, as parts.py."""
import json
import math
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

from parts import examples, of_part, part_of, run

folder_of_examples = examples / "optimisation"


class Minima(unittest.TestCase):
    def told(self, scene, *words, code=0):
        """Of an example by its name, or of a file."""
        file = scene if isinstance(scene, pathlib.Path) else folder_of_examples / f"{scene}.toml"
        told = run(of_part("optimisation"), "gradient", file, *words)
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

    def in_folder(self, text, **files):
        """A scene beside files of numbers, a line of text each."""
        folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        for name, lines in files.items():
            (folder / f"{name}.csv").write_text("\n".join(", ".join(map(repr, line)) for line in lines) + "\n")
        (folder / "scene.toml").write_text(text)
        return folder / "scene.toml"

    def test_differences_of_eigenvalues_that_are_near_each_other_are_narrower_than_these(self):
        for gap in (1e-5, 1e-6, 1e-7, 1e-8):
            # In a basis in which no entry parts them alone.
            a = [[-(i + 1.0 if i > 1 else i * gap) if i == j else 0.0 for j in range(4)] for i in range(4)]
            for i, j, angle in ((0, 2, 0.7), (1, 3, 1.1), (0, 1, 0.4), (2, 3, 0.9), (1, 2, 0.3)):
                c, s = math.cos(angle), math.sin(angle)
                for row in a:
                    row[i], row[j] = c * row[i] - s * row[j], s * row[i] + c * row[j]
                a[i], a[j] = ([c * x - s * y for x, y in zip(a[i], a[j])], [s * x + c * y for x, y in zip(a[i], a[j])])
            a = [[(a[i][j] + a[j][i]) / 2 for j in range(4)] for i in range(4)]
            scene = self.in_folder('problem = "rayleigh"\n[data]\nA = "a.csv"\n[method]\nname = "trust-region"\n'
                                   "[stop]\nrelative_gradient = 1e-12\n", a=a)
            for rows in ("minimum", "minimum,minimiser"):
                found = self.found(scene, "--of", rows, "--wrt", "data.A", "--check")
                self.assertEqual((found["outcome"], found["contradicted"], found["untold"]), ("strict", [], []), gap)
                self.assertGreater(found["digits_agreed"], 3, gap)

    def test_a_start_that_is_the_minimum_is_taken(self):
        text = 'problem = "rayleigh"\n[data]\nA = "a.csv"\n[start]\nfile = "start.csv"\n'
        a = [[3.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 1.0]]
        found = self.found(self.in_folder(text, a=a, start=[[1.0], [0.0], [0.0]]), "--wrt", "data.A.0")
        self.assertEqual((found["status"], found["outcome"], found["derivatives"]), ("converged", "strict", [[-1, 0, 0]]))
        # Nearly there no method finds a step, and the minimum is the same.
        near = self.in_folder(text, a=a, start=[[1.0], [3e-15], [0.0]])
        self.assertEqual(self.found(near, "--wrt", "data.A.0.0")["derivatives"], [[-1]])
        # A saddle is none, and is told.
        self.refused("this is no minimum; begin elsewhere", self.in_folder(text, a=a, start=[[0.0], [1.0], [0.0]]), code=3)

    def test_a_fit_without_residual_has_its_digits(self):
        a = [[1.0, 2.0, 0.5], [0.3, -1.0, 4.0], [2.0, 0.7, 1.0], [-1.5, 0.2, 0.9]]
        c, s = 0.6, 0.8
        turned = [[c * x - s * y, s * x + c * y, z] for x, y, z in a]
        scene = self.in_folder('problem = "procrustes"\n[data]\nA = "a.csv"\nB = "b.csv"\n[start]\ncomponent = 1\n',
                               a=a, b=turned)
        found = self.found(scene, "--of", "minimum,minimiser", "--check")
        self.assertEqual((found["contradicted"], found["untold"]), ([], []))
        self.assertLess(found["values"][0], 1e-25)
        self.assertGreater(min(found["digits_of_minimum"], found["digits_of_minimiser"], found["digits_agreed"]), 9)
        self.assertIn("derivatives of the minimum vanish", self.told(scene).stdout)

    def test_why_nothing_can_be_compared_is_told(self):
        # The second and the third eigenvalue are one.
        self.refused("minimisations beside this one, with another parameters.weights.2, cannot be made (Brockett: the weights",
                     "membrane", "--wrt", "parameters.weights.2", "--set", "parameters.weights=[1,2,3,3,5]", "--check")
        scene = self.in_folder('problem = "positive-definite-mean"\n[data]\nmatrices = "m.csv"\n'
                               '[method]\nname = "conjugate-gradients"\n',
                               m=[[1.0, 0.0], [0.0, 1e-18], [2.0, 0.5], [0.5, 1.0], [1.0, 0.2], [0.2, 3.0]])
        self.refused("point 1 would leave the space P(2) of positive definite matrices", scene, "--wrt", "data.matrices.0.1",
                     "--check")

    def test_an_interrupt_ends_it(self):
        # By ten thousand entries of which each wants equations solved: a minute.
        with subprocess.Popen([of_part("optimisation"), "gradient", folder_of_examples / "membrane.toml", "--wrt", "data.A"],
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as program:
            time.sleep(4)
            self.assertIsNone(program.poll())
            program.send_signal(signal.SIGINT)
            self.assertNotEqual(program.wait(timeout=5), 0)

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
        self.refused("final: ask for minimum", "markers", "--of", "final")
        self.refused("--of: an empty name", "markers", "--of", "")
        self.refused("--wrt: an empty name", "markers", "--wrt", "")
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
