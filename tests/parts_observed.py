#!/usr/bin/env python3
"""`lagroid gradient` of what runs record and ledgers watch beside the state, and what errors of a run become: parts_observed.py BIN EXAMPLES, as parts.py."""
import json
import pathlib
import sys
import tempfile
import unittest

from parts import bin_folder, examples, of_part, rows_of, run


def gradients(part, *words):
    return run(of_part(part).with_name("lagroid-gradient"), *words)


class Observed(unittest.TestCase):
    def checked(self, part, scene, of, *words):
        told = gradients(part, examples / f"{scene}.toml", "--of", of, *words, "--check", "--json")
        self.assertEqual(told.returncode, 0, told.stdout + told.stderr)
        found = json.loads(told.stdout)
        self.assertEqual((found["contradicted"], found["untold"]), ([], []))
        self.assertGreater(found["digits_agreed"], 8, (scene, of))
        return found

    def test_what_ledgers_watch_has_derivatives(self):
        few = ("--set", "time.steps=60")
        for part, scene, of, *words in (
                ("pendulum", "pendulum", "final.energy,integral.H,node.7.energy"),
                ("damped_pendulum", "damped_pendulum", "final.energy", "--set", "time.method=runge-kutta"),
                ("kepler", "kepler", "final.H,final.angular momentum,integral.energy"),
                ("kepler", "kepler_controlled", "final.energy,final.L,final.t"),
                ("kepler", "kepler_reduced", "final.energy,final.angular momentum"),
                ("rigid_body", "rigid_body", "final.energy,final.spatial momentum A M,final.w1,node.20.angular_velocity"),
                ("rigid_body", "rigid_body_moser_veselov", "final.energy,final.Jx"),
                ("rolling_ball", "rolling_ball", "final.momentum about the contact,final.energy,final.w3"),
                ("chaplygin_sleigh", "chaplygin_sleigh", "final.position,final.energy,final.velocities")):
            with self.subTest(scene=scene):
                found = self.checked(part, scene, of, *few, *words)
                self.assertTrue(any(name.startswith("parameters.") for name in found["by"]))

    def test_the_gradient_of_what_is_kept_is_that_at_the_start(self):
        for part, scene, name in (("rigid_body", "rigid_body", "spatial momentum A M"), ("kepler", "kepler", "angular momentum"),
                                  ("rolling_ball", "rolling_ball", "momentum about the contact")):
            told = gradients(part, examples / f"{scene}.toml", "--set", "time.steps=200", "--of", f"final.{name},node.0.{name}", "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            rows = json.loads(told.stdout)["derivatives"]
            for end, start in zip(rows[:len(rows) // 2], rows[len(rows) // 2:], strict=True):
                size = max(abs(x) for x in start)
                for one, other in zip(end, start, strict=True):
                    self.assertAlmostEqual(one, other, delta=1e-10 * size)

    def test_they_are_what_the_run_records(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = (examples / "chaplygin_sleigh.toml", "--set", "time.steps=50")
            out = pathlib.Path(folder) / "run"
            told = run(bin_folder / "lagroid", "run", *scene, "--out", out)
            self.assertEqual(told.returncode, 0, told.stderr)
            last = rows_of(out / "trajectory.csv")[-1]
            names = ("x", "y", "heading", "w", "v1")
            found = json.loads(gradients("chaplygin_sleigh", *scene, "--of", ",".join(f"final.{name}" for name in names), "--json").stdout)
            for name, value in zip(names, found["values"], strict=True):
                self.assertAlmostEqual(value, float(last[name]), delta=1e-12)

    def test_they_are_fitted(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = (examples / "chaplygin_sleigh.toml", "--set", "time.steps=200")
            out = pathlib.Path(folder) / "run"
            self.assertEqual(run(bin_folder / "lagroid", "run", *scene, "--set", "parameters.offset=0.4", "--out", out).returncode, 0)
            told = gradients("chaplygin_sleigh", "fit", *scene[:1], out / "trajectory.csv", *scene[1:], "--of", "x,y,heading", "--wrt",
                             "parameters.offset", "--json")
            self.assertEqual(told.returncode, 0, told.stdout + told.stderr)
            self.assertAlmostEqual(json.loads(told.stdout)["unknowns"][0]["value"], 0.4, delta=1e-9)

    def test_columns_of_ones_own_come_first(self):
        words = ("--set", "time.steps=20", "--wrt", "parameters", "--json")
        for part, name, text in (("rigid_body", "w1", "2*M1"), ("kepler", "L", "2*px")):
            found = json.loads(gradients(part, examples / f"{part}.toml", "--column", f"{name}={text}", "--of", f"final.{name}", *words).stdout)
            plain = json.loads(gradients(part, examples / f"{part}.toml", "--of", f"final.{text[2:]}", *words).stdout)
            self.assertEqual(found["values"], [2 * plain["values"][0]])

    def test_angles_are_fitted_whole_turns_apart(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = (examples / "chaplygin_sleigh.toml", "--set", "initial.position=[0,0,3.0]")
            out = pathlib.Path(folder) / "run"
            self.assertEqual(run(bin_folder / "lagroid", "run", *scene, "--set", "parameters.mass=1.3", "--out", out).returncode, 0)
            rows = rows_of(out / "trajectory.csv")
            self.assertGreater(max(float(row["heading"]) for row in rows) - min(float(row["heading"]) for row in rows), 6)
            told = gradients("chaplygin_sleigh", "fit", scene[0], out / "trajectory.csv", *scene[1:], "--of", "heading", "--wrt",
                             "parameters.mass", "--json")
            self.assertEqual(told.returncode, 0, told.stdout + told.stderr)
            self.assertAlmostEqual(json.loads(told.stdout)["unknowns"][0]["value"], 1.3, delta=1e-8)

    def test_columns_are_called_as_runs_call_them(self):
        event = ("--set", 'event=[{name = "low", when = "H - 0.2", direction = "falling"}]', "--set", "time.steps=400")
        self.assertEqual(run(of_part("damped_pendulum"), "run", examples / "damped_pendulum.toml", *event).returncode, 0)
        found = self.checked("damped_pendulum", "damped_pendulum", "event.low.1.t,event.low.1.H,final.energy", *event)
        self.assertEqual(found["of"][-1], "final.H")

    def test_kinks_have_none(self):
        words = (examples / "pendulum.toml", "--set", "initial.position=[0.0]", "--set", "time.steps=3", "--of", "node.0.z", "--wrt", "initial.q")
        for text in ("max(q,0)", "min(q,2*q)", "sign(q)", "abs(q)"):
            told = gradients("pendulum", *words, "--column", f"z={text}")
            self.assertEqual((told.returncode, len(told.stderr.splitlines())), (3, 1), (text, told.stdout))
            self.assertIn("no finite derivative", told.stderr)
        for text, slope in (("max(q,-1)", 1), ("min(q,q)", 1), ("max(q,1)", 0)):
            found = json.loads(gradients("pendulum", *words, "--column", f"z={text}", "--json").stdout)
            self.assertEqual(found["derivatives"], [[slope]])

    def test_what_has_no_derivative_says_why(self):
        for part, scene, name, why in (("rigid_body", "rigid_body", "final.A_w", "known up to its sign"),
                                       ("damped_pendulum", "damped_pendulum", "final.energy less work", "adds up along the run"),
                                       ("rolling_ball", "rolling_ball", "final.lambda1", "are of arrows"),
                                       ("kepler", "kepler", "final.w", "nothing of that name")):
            told = gradients(part, examples / f"{scene}.toml", "--of", name)
            self.assertEqual((told.returncode, len(told.stderr.splitlines())), (2, 1), told.stdout + told.stderr)
            self.assertIn(why, told.stderr)

    def test_events_are_of_them_too(self):
        for event in ('{name = "x", when = "q", set = ["gravity = energy + 2"]}', '{name = "x", when = "p - energy", direction = "rising"}'):
            found = self.checked("pendulum", "pendulum", "final,events,event.x.1.energy", "--set", "time.steps=60", "--set",
                                 f"event=[{event}]")
            self.assertIn("event.x.1.t", found["of"])

    def test_all_that_there_is_is_the_state(self):
        found = json.loads(gradients("pendulum", examples / "pendulum.toml", "--json").stdout)
        self.assertEqual(found["of"], ["final.q", "final.p"])

    def test_the_way_back_keeps_to_its_budget(self):
        words = (examples / "kepler.toml", "--set", "time.steps=2000", "--of", "final.position", "--json")
        forward = json.loads(gradients("kepler", *words).stdout)
        back = json.loads(gradients("kepler", *words, "--states", "9").stdout)
        self.assertEqual(forward["states_kept"], 1)
        self.assertLessEqual(back["states_kept"], 9)
        self.assertGreater(back["steps_solved"], 2 * 2000)
        for one, other in zip(back["derivatives"], forward["derivatives"], strict=True):
            size = max(abs(x) for x in other)
            for a, b in zip(one, other, strict=True):
                self.assertAlmostEqual(a, b, delta=1e-11 * size)
        told = gradients("kepler", examples / "kepler.toml", "--set", "time.steps=50", "--states", "5", "--of", "final.x")
        self.assertRegex(told.stdout, r"steps were solved, with up to [1-5] states kept on the way back")
        told = gradients("kepler", examples / "kepler_boundary.toml", "--states", "5")
        self.assertEqual((told.returncode, len(told.stderr.splitlines())), (2, 1), told.stderr)

    def test_angles_of_many_turns_are_not_contradicted(self):
        found = self.checked_angle("--set", "time.steps=20000")
        self.assertEqual(found["contradicted"], [])

    def checked_angle(self, *words):
        told = gradients("pendulum", examples / "pendulum.toml", "--set", "initial.momentum=[3000.0]", *words, "--of", "final.q", "--wrt",
                         "initial.momentum,parameters.length", "--check", "--json")
        self.assertEqual(told.returncode, 0, told.stdout + told.stderr)
        return json.loads(told.stdout)


class ErrorsOfRuns(unittest.TestCase):
    def test_a_run_goes_on_with_what_errors_become(self):
        scene = (examples / "pendulum.toml", "--set", "time.steps=100")
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "run"
            told = run(of_part("pendulum"), "run", *scene, "--out", out, "--deviations", "initial.momentum=0.02,parameters.length=0.01")
            self.assertEqual(told.returncode, 0, told.stderr)
            self.assertTrue((out / "trajectory.csv").exists())
            alone = run(of_part("pendulum"), "gradient", *scene, "--deviations", "initial.momentum=0.02,parameters.length=0.01")
            self.assertTrue(told.stdout.endswith(alone.stdout), told.stdout)
            self.assertIn("converged", told.stdout[:-len(alone.stdout)])
            self.assertEqual((out / "errors.txt").read_text(), alone.stdout)
            # What cannot be carried is told before anything is run.
            told = run(of_part("pendulum"), "run", *scene, "--out", pathlib.Path(folder) / "none", "--deviations", "initial.zz=1")
            self.assertEqual((told.returncode, told.stdout, len(told.stderr.splitlines())), (2, "", 1), told.stderr)
            self.assertFalse((pathlib.Path(folder) / "none").exists())
            told = run(of_part("pendulum"), "fit", *scene[:1], out / "trajectory.csv", *scene[1:], "--wrt", "parameters.length", "--json")
            file = pathlib.Path(folder) / "fit.json"
            file.write_text(told.stdout)
            told = run(of_part("pendulum"), "run", *scene, "--covariance", file)
            self.assertEqual(told.returncode, 0, told.stderr)
            self.assertIn("what errors become", told.stdout)
        told = run(of_part("pendulum"), "run", *scene, "--covariance", "nowhere.json")
        self.assertEqual((told.returncode, told.stdout, len(told.stderr.splitlines())), (2, "", 1), told.stderr)
        self.assertNotEqual(run(of_part("pendulum"), "run", *scene, "--json", "--deviations", "initial.q=1").returncode, 0)

    def test_errors_without_squares_are_told(self):
        told = run(of_part("pendulum"), "gradient", examples / "pendulum.toml", "--deviations", "initial.q=1e200")
        self.assertEqual((told.returncode, len(told.stderr.splitlines())), (3, 1), told.stdout + told.stderr)
        self.assertIn("no finite number", told.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
