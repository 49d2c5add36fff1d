#!/usr/bin/env python3
"""What `lagroid gradient` says of its own derivatives, and columns that are computed: parts_checks.py BIN EXAMPLES, as parts.py."""
import json
import math
import pathlib
import sys
import tempfile
import unittest

from parts import bin_folder, examples, of_part, rows_of, run


def told(part, scene, *words):
    done = run(of_part(part), "gradient", scene, *words, "--json")
    assert done.returncode == 0, done.stdout + done.stderr
    return json.loads(done.stdout)


class Checks(unittest.TestCase):
    def test_computed_columns_are_of_the_columns_that_they_name(self):
        for part, scene, of in (("pendulum", "pendulum", "q"), ("damped_pendulum", "damped_pendulum", "q"), ("kepler", "kepler", "x"),
                                ("kepler", "kepler_controlled", "x"), ("bodies", "spring_pendulum", "bob.x")):
            found = told(part, examples / f"{scene}.toml", "--set", "time.steps=10", "--of", f"final.{of},final.w,final.twice", "--column",
                         f"w=sin({of})", "--column", "twice=2*w", "--check")
            x, w, twice = found["values"]
            self.assertAlmostEqual(w, math.sin(x), delta=1e-14)
            for by_x, by_w, by_twice in zip(*found["derivatives"]):
                self.assertAlmostEqual(by_w, math.cos(x) * by_x, delta=1e-12 * (1 + abs(by_x)))
                self.assertEqual(by_twice, 2 * by_w)
            self.assertGreater(found["digits_agreed"], 7, scene)

    def test_computed_columns_are_fitted(self):
        with tempfile.TemporaryDirectory() as folder:
            short = ("--set", "time.steps=50")
            done = run(of_part("pendulum"), "run", examples / "pendulum.toml", *short, "--set", "parameters.length=1.1", "--out", folder)
            self.assertEqual(done.returncode, 0, done.stderr)
            data = pathlib.Path(folder) / "sines.csv"
            data.write_text("t,s\n" + "".join(f"{row['t']},{math.sin(float(row['q']))!r}\n"
                                             for row in rows_of(pathlib.Path(folder) / "trajectory.csv")))
            done = run(of_part("pendulum"), "fit", examples / "pendulum.toml", data, *short, "--wrt", "parameters.length", "--column",
                       "s=sin(q)", "--json")
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            self.assertAlmostEqual(json.loads(done.stdout)["unknowns"][0]["value"], 1.1, delta=1e-8)
            done = run(of_part("pendulum"), "fit", examples / "pendulum.toml", data, *short, "--wrt", "parameters.length", "--column",
                       "s=sin(q)", "--combination", "none=log(parameters.length-9)")
            self.assertEqual((done.returncode, done.stdout, len(done.stderr.splitlines())), (2, "", 1), done.stderr)
            self.assertIn("none=log(parameters.length-9): it is no finite number", done.stderr)

    def test_one_function_by_many_numbers_has_a_line_for_each(self):
        found = told("bodies", examples / "spring_pendulum.toml", "--set", "time.steps=5", "--of", "final.energy")
        done = run(of_part("bodies"), "gradient", examples / "spring_pendulum.toml", "--set", "time.steps=5", "--of", "final.energy")
        self.assertGreater(len(found["by"]), 6)
        lines = [line.split() for line in done.stdout.splitlines()]
        for name, derivative in zip(found["by"], found["derivatives"][0]):
            self.assertIn(["by", name, f"{derivative:.10g}"], lines)

    def test_empty_words_are_no_words(self):
        scene = examples / "pendulum.toml"
        for command, *words in (("gradient", "--covariance", ""), ("gradient", "--of", " "), ("fit", "data.csv", "--residuals", "")):
            done = run(of_part("pendulum"), command, scene, *words)
            self.assertEqual((done.returncode, done.stdout, len(done.stderr.splitlines())), (2, "", 1), done.stderr)
        with tempfile.TemporaryDirectory() as folder:
            done = run(of_part("pendulum"), "gradient", scene, "--covariance", folder)
            self.assertEqual((done.returncode, len(done.stderr.splitlines())), (2, 1), done.stderr)
            self.assertIn("cannot be read", done.stderr)
        self.assertEqual(told("pendulum", scene, "--set", "time.steps=5", "--of", "final.q, final.p")["of"], ["final.q", "final.p"])

    def test_a_row_without_a_size_has_no_digits(self):
        found = told("pendulum", examples / "pendulum.toml", "--set", "time.steps=40", "--of", "final.q,final.none", "--column",
                     "none=0*q", "--check")
        self.assertLess(found["digits_agreed"], 15)

    def test_a_kick_that_is_no_number_is_named(self):
        infinite = 'event=[{name = "low", when = "q", kick = ["1/0"]}]'
        for method in ("splitting", "runge-kutta", "variational"):
            done = run(of_part("pendulum"), "gradient", examples / "pendulum.toml", "--set", f"time.method={method}", "--set", infinite)
            self.assertEqual((done.returncode, done.stdout, len(done.stderr.splitlines())), (3, "", 1), done.stderr)
            self.assertRegex(done.stderr, "the kick of event .low.*is no finite number")

    def test_control_has_no_gradient_here(self):
        done = run(of_part("pendulum"), "gradient", examples / "control" / "swing_up.toml")
        self.assertEqual((done.returncode, done.stdout, len(done.stderr.splitlines())), (2, "", 1), done.stderr)
        self.assertIn("control: there are no derivatives of what lagroid control finds", done.stderr)

    def test_columns_without_a_value_are_told(self):
        words = ("gradient", examples / "pendulum.toml", "--set", "time.steps=10", "--of", "final.w", "--column", "w=log(q-9)")
        done = run(of_part("pendulum"), *words)
        self.assertEqual((done.returncode, done.stdout, len(done.stderr.splitlines())), (3, "", 1), done.stderr)
        self.assertIn("final.w is no finite number", done.stderr)
        done = run(of_part("pendulum"), *words, "--json")
        self.assertEqual((done.returncode, json.loads(done.stdout)["status"]), (3, "failed"))

    def test_differences_are_as_narrow_as_long_runs_want_them(self):
        for part, scene, words in (
                ("pendulum", "pendulum", ("time.steps=20000", "--of", "final.q", "--wrt", "parameters.length")),
                ("pendulum", "pendulum", ("time.steps=10", "--set", "time.step=100", "--of", "final")),
                ("kepler", "kepler", ("time.steps=500", "--of", "final.L", "--column", "L=x*py-y*px", "--wrt", "parameters"))):
            found = told(part, examples / f"{scene}.toml", "--set", *words, "--check")
            self.assertEqual((found["contradicted"], found["untold"]), ([], []), words)
            self.assertGreater(found["digits_agreed"], 5, words)

    def test_growth_is_that_of_the_run(self):
        # Whatever derivatives are asked for.
        for words in (("time.steps=2000",), ("time.steps=100", "--set", "time.mode=controlled")):
            growths = [told("pendulum", examples / "pendulum.toml", "--of", "final.q", "--wrt", wrt, "--set", *words)["growth"]
                       for wrt in ("initial", "parameters.length", "parameters")]
            for each in growths:
                self.assertAlmostEqual(each / growths[0], 1, delta=1e-6)
            self.assertLess(growths[0], 1e4)
        # And in any units: an orbit in metres and seconds, and in others.
        with tempfile.TemporaryDirectory() as folder:
            growths = {}
            for name, length, time in (("si", 1, 1), ("tiny", 1e-12, 1e-4)):
                scene = pathlib.Path(folder) / f"{name}.toml"
                scene.write_text(f'system = "kepler"\n[parameters]\nstrength = {3.986e14 * length**3 / time**2!r}\n'
                                 f"[time]\nstep = {10.0 * time!r}\nsteps = 600\n[initial]\nposition = [{7e6 * length!r}, 0.0]\n"
                                 f"momentum = [0.0, {7546.0 * length / time!r}]\n")
                for mode in ("fixed", "controlled", "prescribed"):
                    growths[name, mode] = told("kepler", scene, "--set", f"time.mode={mode}")["growth"]
            for mode in ("fixed", "controlled", "prescribed"):
                self.assertAlmostEqual(growths["tiny", mode] / growths["si", mode], 1, delta=1e-6, msg=str(growths))

    def test_growth_at_rest_is_that_of_what_has_a_size(self):
        # At the upper equilibrium momenta are round-off of the angle; a small one is a momentum.
        def upright(momentum, steps=50):
            return told("pendulum", examples / "pendulum.toml", "--of", "final.q", "--wrt", "initial.q", "--check", "--set",
                        f"time.steps={steps}", "--set", "initial.position=[3.141592653589793]", "--set",
                        f"initial.momentum=[{momentum}]")
        rest = upright(0)
        self.assertAlmostEqual(rest["growth"] / rest["derivatives"][0][0], 1, delta=1e-6)
        self.assertEqual((rest["contradicted"], rest["untold"]), ([], []))
        self.assertGreater(rest["digits_agreed"], 8)
        self.assertGreater(upright(1e-9)["growth"], 1e8)
        # Where errors grow beyond all digits nothing is told.
        for steps in (300, 500):
            self.assertEqual(upright(0, steps)["contradicted"], [], steps)
        hanging = told("spheres", examples / "pendulum_chain.toml", "--of", "final.x3", "--set", "time.steps=50", "--set",
                       "initial={theta=[3.141592653589793,3.141592653589793,3.141592653589793],phi=[0,0,0],"
                       "angular_velocities=[[0,0,0],[0,0,0],[0,0,0]]}")
        self.assertLess(hanging["growth"], 1e3)

    def test_inner_steps_of_a_tolerance_are_known_to_it(self):
        chain = ("spheres", examples / "pendulum_chain.toml", "--set", "time.step=0.05", "--set", "time.steps=40", "--of", "final.x3",
                 "--wrt", "parameters", "--check")
        for method in ("extrapolation", "munthe-kaas-54"):
            for tolerance in (1e-2, 1e-4, 1e-10):
                found = told(*chain, "--set", f"time.method={method}", "--set", f"time.tolerance={tolerance}")
                self.assertEqual(found["contradicted"], [], (method, tolerance))
                self.assertEqual(found["untold"] == [], tolerance < 1e-9, (method, tolerance))
                self.assertLessEqual(found["digits_left"], -math.log10(tolerance), (method, tolerance))
        done = run(of_part("kepler"), "gradient", examples / "kepler.toml", "--set", "time.method=extrapolation", "--set",
                   "time.tolerance=1e-3", "--set", "time.step=0.5", "--set", "time.steps=10", "--of", "final.x,final.y", "--check")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("cannot tell", done.stdout)
        self.assertNotIn("0.0 digits", done.stdout)

    def test_what_is_zero_by_cancellation_is_not_contradicted(self):
        # The momentum about the vertical of three rods in a plane: terms of size one, whose sum is zero.
        plane = ("spheres", examples / "pendulum_chain.toml", "--of", "final.Jz", "--check", "--set", "time.steps=300", "--set",
                 "initial={theta=[1.9,1.4,2.6],phi=[0.3,0.3,0.3],angular_velocities=[[0,0,0],[0,0,0],[0,0,0]]}")
        found = told(*plane, "--wrt", "parameters")
        self.assertEqual(found["contradicted"], [])
        self.assertLess(max(abs(each) for row in found["derivatives"] for each in row), 1e-11)
        # What it does depend on is told beside them.
        turned = told(*plane, "--wrt", "initial")
        self.assertEqual(turned["contradicted"], [])
        self.assertGreater(turned["digits_agreed"], 8)

    @unittest.skipUnless((bin_folder / "lagroid-gradient").exists(), "of the whole program, built for the nightly tests")
    def test_controlled_steps_of_a_symmetric_top_are_smooth_in_its_moments(self):
        # Two moments of Lagrange's top are equal: what controls its steps has no corner there.
        done = run(bin_folder / "lagroid-gradient", examples / "heavy_top.toml", "--set",
                   "time.mode=controlled", "--set", "time.steps=40", "--of", "final", "--wrt", "parameters.inertia", "--check", "--json")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        found = json.loads(done.stdout)
        self.assertEqual((found["contradicted"], found["untold"]), ([], []))
        self.assertGreater(found["digits_agreed"], 6)

    def test_a_check_and_a_tolerance_are_not_ignored(self):
        done = run(of_part("pendulum"), "gradient", examples / "pendulum.toml", "--deviations", "initial.p=0.1", "--check")
        self.assertEqual((done.returncode, len(done.stderr.splitlines())), (2, 1), done.stderr)
        self.assertIn("--check", done.stderr)
        done = run(of_part("bodies"), "gradient", examples / "spring_pendulum.toml", "--set", "solver={tolerance=1e-3}")
        self.assertEqual((done.returncode, len(done.stderr.splitlines())), (2, 1), done.stderr)
        self.assertIn("solver.tolerance", done.stderr)
        self.assertIn("round-off", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
