"""Studies, and the program that asks laws."""

import contextlib
import os
import stat
import tempfile
import time
import unittest
from pathlib import Path
from typing import Iterator
from unittest import mock

import lagroid
from data import EXAMPLES


@contextlib.contextmanager
def stand_in(variable: str, script: str) -> Iterator[None]:
    """In the place of the program that an environment variable names: they are built apart, and compile for minutes."""
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "program"
        program.write_text("#!/bin/sh\n" + script)
        program.chmod(program.stat().st_mode | stat.S_IXUSR)
        with mock.patch.dict(os.environ, {variable: str(program)}):
            yield


class Studies(unittest.TestCase):
    def test_study(self) -> None:
        found = lagroid.study(
            EXAMPLES / "kepler.toml",
            set={"time.steps": 100},
            methods=["splitting", "variational/suzuki"],
            steps=[0.1, 0.05, 0.025],
            reference_time=1,
            repetitions=2,
        )
        self.assertEqual(found["status"], "done")
        runs = [run for run in found["runs"] if run["method"] == "splitting"]
        self.assertEqual(len(runs), 3)
        self.assertAlmostEqual(runs[-2]["trajectory"] / runs[-1]["trajectory"], 4, delta=0.5)
        self.assertTrue(found["recommendation"])
        self.assertEqual(found["not_measured"], [])

    def test_a_study_keeps_its_budget(self) -> None:
        start = time.monotonic()
        found = lagroid.study(EXAMPLES / "kepler.toml", budget=10)
        self.assertLess(time.monotonic() - start, 30)
        self.assertTrue(found["not_measured"])
        with self.assertRaises(ValueError):
            lagroid.study(EXAMPLES / "kepler.toml", budget=0)

    def test_methods(self) -> None:
        found = {method.name: method for method in lagroid.methods(EXAMPLES / "kepler.toml")}
        self.assertEqual(found["splitting/kahan-li-8"].order, 8)
        with self.assertRaises(lagroid.SceneError):
            lagroid.study(EXAMPLES / "kepler.toml", methods=["magic"])
        with self.assertRaises(lagroid.SceneError):
            lagroid.methods(EXAMPLES / "kepler_boundary.toml")
        with self.assertRaises(ValueError):
            lagroid.study(EXAMPLES / "kepler.toml", steps=[-1.0])

    def test_check_by_the_program_itself(self) -> None:
        try:
            short = {"time.steps": 50}
            certificate = lagroid.check(EXAMPLES / "pendulum.toml", set=short, arguments=["--samples", "5"])
        except lagroid.ProgramError as error:
            if "ninja lagroid_check" not in str(error):  # what it says where the program is not there
                raise
            self.skipTest(str(error))
        self.assertEqual(certificate["status"], "certified")

    def test_check_hands_over_to_its_program(self) -> None:
        with stand_in("LAGROID_CHECK", 'printf \'{"arguments": "%s", "scene": "%s"}\' "$2 $3" "$(head -c 6 "$1")"\n'):
            found = lagroid.check(EXAMPLES / "kepler.toml", arguments=["--samples=5"])
        self.assertEqual(found["arguments"], "--json --samples=5")
        # A file is handed over as it is, because what it names stands beside it.
        with stand_in("LAGROID_CHECK", 'printf \'{"scene": "%s", "set": "%s"}\' "$1" "$3 $4"\n'):
            found = lagroid.check(EXAMPLES / "learned_hamiltonian.toml", set={"time.steps": 3})
        self.assertEqual(found["scene"], str(EXAMPLES / "learned_hamiltonian.toml"))
        self.assertEqual(found["set"], "--set time.steps=3")
        with stand_in("LAGROID_CHECK", 'echo "lagroid: $1: mistaken" >&2\nexit 2\n'):
            with self.assertRaisesRegex(lagroid.SceneError, "kepler.toml: mistaken"):
                lagroid.check(EXAMPLES / "kepler.toml")
        with stand_in("LAGROID_CHECK", "exit 1\n"):
            with self.assertRaises(lagroid.ProgramError):
                lagroid.check(EXAMPLES / "kepler.toml")

    def test_gradient_hands_over_to_its_program(self) -> None:
        script = (
            '[ "$2 $3 $4 $5 $6" = "--json --of final.x --wrt initial,parameters.strength" ] || exit 1\n'
            'echo \'{"of": ["final.x"], "by": ["initial.x", "parameters.strength"], "values": [1.5],'
            ' "derivatives": [[2, 3]], "growth": 4, "digits_left": 15}\'\n'
        )
        with stand_in("LAGROID_GRADIENT", script):
            found = lagroid.gradient(EXAMPLES / "kepler.toml", of=["final.x"], wrt=["initial", "parameters.strength"])
            alone = lagroid.gradient(EXAMPLES / "kepler.toml", of="final.x", wrt="initial,parameters.strength")
            with self.assertRaisesRegex(TypeError, "3 is none"):
                lagroid.gradient(EXAMPLES / "kepler.toml", of=[3])
        self.assertEqual(found.derivatives.tolist(), [[2, 3]])
        self.assertEqual(alone.by, found.by)
        self.assertEqual(found.by[1], "parameters.strength")
        self.assertIsNone(found.differences)

    def test_a_run_has_the_gradient_of_its_scene(self) -> None:
        script = (
            'grep -q "strength = 2" "$1" || echo "$*" | grep -q "parameters.strength=2.0" || exit 1\n'
            '[ "$2 $3 $4" = "--json --of final.energy" ] || exit 1\n'
            'echo \'{"of": ["final.energy"], "by": ["initial.x"], "values": [1.5], "derivatives": [[2]], "growth": 4,'
            ' "digits_left": 15, "steps_solved": 20}\'\n'
        )
        few = {"time.steps": 3, "parameters.strength": 2.0}
        file = EXAMPLES / "kepler.toml"
        for scene in (file, file.read_text()):
            run = lagroid.run(scene, set=few)
            with stand_in("LAGROID_GRADIENT", script):
                found = run.gradient(of="final.energy")
            self.assertEqual((found.derivatives.tolist(), found.steps_solved), ([[2]], 20))
        watched = lagroid.run(file, set=few, events=[{"name": "here", "when": lambda node: node["x"]}])
        with self.assertRaisesRegex(ValueError, "does not hold its scene"):
            watched.gradient()

    def test_uncertainty_hands_over_to_the_same_program(self) -> None:
        script = (
            '[ "$*" = "$1 --json --of final.x --deviations initial.momentum=0.01 --draws 10 --seed 3" ] || exit 1\n'
            'echo \'{"of": ["final.x"], "by": ["initial.px"], "values": [1.5], "derivatives": [[2]],'
            ' "deviations": [0.01], "covariance": [[4e-4]], "draws": {"mean": [1.4], "covariance": [[5e-4]]}}\'\n'
        )
        with stand_in("LAGROID_GRADIENT", script):
            found = lagroid.uncertainty(
                EXAMPLES / "kepler.toml", {"initial.momentum": 0.01}, of=["final.x"], draws=10, seed=3
            )
        self.assertEqual(found.covariance.tolist(), [[4e-4]])
        assert found.drawn_mean is not None
        self.assertEqual(found.drawn_mean.tolist(), [1.4])

    def test_uncertainty_of_what_was_fitted_gives_the_program_the_fit(self) -> None:
        fitted = {"unknowns": [{"name": "initial.px", "value": 1.5, "deviation": 0.01}], "covariance": [[1e-4]]}
        script = (
            '[ "$3 $4 $5 $6 $7" = "--of final.r --column r=sqrt(x^2 + y^2) --covariance" ] || exit 1\n'
            'grep -q initial.px "$8" || exit 1\n'
            'echo \'{"of": ["final.r"], "by": ["initial.px"], "values": [1.5], "derivatives": [[2]],'
            ' "deviations": [0.01], "covariance": [[4e-4]]}\'\n'
        )
        with stand_in("LAGROID_GRADIENT", script):
            found = lagroid.uncertainty(
                EXAMPLES / "kepler.toml", fitted=fitted, of=["final.r"], columns={"r": "sqrt(x^2 + y^2)"}
            )
        self.assertEqual(found.covariance.tolist(), [[4e-4]])
        self.assertIsNone(found.drawn_mean)
        with self.assertRaises(ValueError):
            lagroid.uncertainty(EXAMPLES / "kepler.toml")

    def test_fit_hands_over_to_the_same_program(self) -> None:
        script = (
            '[ "$*" = "fit $2 --json a.csv --wrt initial --sigma x=0.1 --bounds parameters.strength=0.5:2.0" ]'
            " || exit 1\n"
            'echo \'{"status": "converged", "message": "", "unknowns": [{"name": "initial.px", "value": 1.5}]}\'\n'
        )
        with stand_in("LAGROID_GRADIENT", script):
            found = lagroid.fit(
                EXAMPLES / "kepler.toml",
                ["a.csv"],
                ["initial"],
                sigma={"x": 0.1},
                bounds={"parameters.strength": (0.5, 2.0)},
            )
            one = lagroid.fit(
                EXAMPLES / "kepler.toml",
                Path("a.csv"),
                ["initial"],
                sigma={"x": 0.1},
                bounds={"parameters.strength": (0.5, 2.0)},
            )
        self.assertEqual(found["unknowns"][0]["value"], 1.5)
        self.assertEqual(one, found, "a single file needs no list")
        with stand_in("LAGROID_GRADIENT", 'echo \'{"status": "failed", "message": "run 1 fails"}\'\nexit 3\n'):
            with self.assertRaisesRegex(lagroid.SolveError, "run 1 fails"):
                lagroid.fit(EXAMPLES / "kepler.toml", ["a.csv"], ["initial"])

    def test_check_without_its_program_says_how_to_build_it(self) -> None:
        with mock.patch("lagroid.programs._lagroid.__file__", "/nowhere/python/lagroid/_lagroid.so", create=True):
            with mock.patch.dict(os.environ, {"PATH": "/nowhere"}):
                with self.assertRaisesRegex(lagroid.ProgramError, "ninja lagroid_check"):
                    lagroid.check(EXAMPLES / "kepler.toml")


if __name__ == "__main__":
    unittest.main()
