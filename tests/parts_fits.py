#!/usr/bin/env python3
"""`lagroid fit` finds the numbers that data were made with: parts_fits.py BIN EXAMPLES, as parts.py."""
import json
import pathlib
import random
import re
import sys
import tempfile
import unittest

from parts import examples, of_part, rows_of, run


class Fits(unittest.TestCase):
    def measured(self, folder, name, noise=0.0, seed=1, *settings):
        """The rows of a pendulum's run, with normal errors in q and p, as a file."""
        out = pathlib.Path(folder) / f"{name} run"
        told = run(of_part("pendulum"), "run", examples / "pendulum.toml", "--set", "time.steps=200", *settings, "--out", out)
        self.assertEqual(told.returncode, 0, told.stderr)
        draw = random.Random(seed)
        rows = rows_of(out / "trajectory.csv")
        file = pathlib.Path(folder) / f"{name}.csv"
        lines = ["t,q,p,temperature"]
        for i, row in enumerate(rows):
            q, p = (repr(float(row[key]) + noise * draw.gauss(0, 1)) for key in ("q", "p"))
            lines.append(f"{row['t']},{q},{'' if i % 7 == 3 else p},20")  # some momenta are missing
        file.write_text("\n".join(lines) + "\n")
        return file

    def fitted(self, *words, code=0):
        told = run(of_part("pendulum"), "fit", examples / "pendulum.toml", *words, "--json")
        self.assertEqual(told.returncode, code, told.stderr + told.stdout)
        return json.loads(told.stdout)

    def test_parameters_come_back_from_what_was_measured(self):
        with tempfile.TemporaryDirectory() as folder:
            data = self.measured(folder, "exact", 0.0, 1, "--set", "parameters.length=1.3", "--set", "parameters.mass=0.8")
            found = self.fitted(data, "--wrt", "parameters.length,parameters.mass,initial")
            value = {each["name"]: each["value"] for each in found["unknowns"]}
            self.assertEqual(found["status"], "converged")
            self.assertAlmostEqual(value["parameters.length"], 1.3, delta=1e-9)
            self.assertAlmostEqual(value["parameters.mass"], 0.8, delta=1e-9)
            self.assertEqual((found["undetermined"], found["ignored"]), ([], ["temperature"]))
            # The run's own file of numbers tells the same.
            binary = next(pathlib.Path(folder).rglob("trajectory.h5"))
            same = self.fitted(binary, "--wrt", "parameters.length,parameters.mass,initial", "--of", "q,p")
            self.assertEqual([round(each["value"], 9) for each in same["unknowns"]],
                             [round(each["value"], 9) for each in found["unknowns"]])
            # Angles alone know of no mass; and of length and gravity their ratio.
            found = self.fitted(data, "--of", "q", "--wrt", "parameters", "--set", "initial.momentum=[0]")
            self.assertEqual(len(found["undetermined"]), 2)
            # What is not used is told, and why.
            self.assertEqual((found["left_out"], found["ignored"]), (["p"], ["temperature"]))
            told = run(of_part("pendulum"), "fit", examples / "pendulum.toml", data, "--of", "q", "--wrt", "initial, parameters.length")
            self.assertIn("not fitted, as --of can choose: p\n", told.stdout)
            self.assertRegex(told.stdout, "ignored, for .*: temperature\n")
            # So are gaps.
            told = run(of_part("pendulum"), "fit", examples / "pendulum.toml", data, "--wrt", "parameters.length")
            self.assertRegex(told.stdout, r"note: .*exact.csv: of p \d+ of 201 fields are empty or NaN")

    def test_what_is_fitted_is_as_far_off_as_its_deviation_says(self):
        with tempfile.TemporaryDirectory() as folder:
            squares, counts, whites = 0.0, 0, 0
            for seed in range(12):
                data = self.measured(folder, f"noisy{seed}", 0.01, seed, "--set", "parameters.length=1.1")
                found = self.fitted(data, "--wrt", "parameters.length,initial.momentum", "--sigma", "q=0.01,p=0.01")
                self.assertAlmostEqual(found["scale"], 1, delta=0.2)
                whites += sum(each["white"] for each in found["columns"])
                length = found["unknowns"][1]
                self.assertEqual(length["name"], "parameters.length")
                squares += ((length["value"] - 1.1) / length["deviation"]) ** 2
                counts += 1
            self.assertGreaterEqual(whites, 22)
            # Chi squared of twelve: outside of these once in a thousand.
            self.assertTrue(2.2 < squares < 33, squares)

    def test_the_pendulum_of_the_page_is_found(self):
        told = run(of_part("damped_pendulum"), "fit", examples / "damped_pendulum.toml", examples / "measured_pendulum.csv",
                   "--wrt", "initial,parameters.length,parameters.damping", "--sigma", "q=0.01", "--json")
        self.assertEqual(told.returncode, 0, told.stderr)
        found = json.loads(told.stdout)
        for each, made in zip(found["unknowns"], (2, 0, 1.24, 0.083)):
            self.assertLess(abs(each["value"] - made), 4 * each["deviation"], each)
        page = (examples.parent / "docs" / "fit.md").read_text()
        for each in found["unknowns"]:
            shown = re.search(re.escape(each["name"]) + r" +([-.e\d]+) +([-.e\d]+)", page)
            self.assertAlmostEqual(float(shown[1]), each["value"], delta=1e-3 * each["deviation"])
            self.assertAlmostEqual(float(shown[2]), each["deviation"], delta=1e-2 * each["deviation"])
        self.assertTrue(found["columns"][0]["white"])

    def test_runs_share_parameters_and_have_their_own_starts(self):
        with tempfile.TemporaryDirectory() as folder:
            files = [self.measured(folder, f"run{i}", 0.0, 1, "--set", "parameters.length=1.2", "--set",
                                   f"initial.momentum=[{p}]") for i, p in enumerate((0.1, -0.3))]
            found = self.fitted(*files, "--wrt", "parameters.length,initial.momentum")
            value = {each["name"]: each["value"] for each in found["unknowns"]}
            self.assertAlmostEqual(value["initial.p of run 1"], 0.1, delta=1e-9)
            self.assertAlmostEqual(value["initial.p of run 2"], -0.3, delta=1e-9)
            self.assertAlmostEqual(value["parameters.length"], 1.2, delta=1e-9)

    def test_outliers_are_borne_bounds_kept_and_residuals_written(self):
        with tempfile.TemporaryDirectory() as folder:
            data = self.measured(folder, "outliers", 0.001, 3, "--set", "parameters.length=1.2")
            lines = data.read_text().splitlines()
            for k in range(10, 200, 17):
                t, q, *others = lines[k].split(",")
                lines[k] = ",".join([t, repr(float(q) + 0.5), *others])
            data.write_text("\n".join(lines) + "\n")
            words = (data, "--wrt", "parameters.length", "--sigma", "q=0.001,p=0.001")
            off = [abs(self.fitted(*words, *more)["unknowns"][0]["value"] - 1.2) for more in ((), ("--huber", "2"))]
            self.assertLess(off[1], 0.2 * off[0])
            table = pathlib.Path(folder) / "residuals.csv"
            bounded = self.fitted(*words, "--bounds", "parameters.length=0.9:1.1", "--residuals", table, "--starts", "3")
            self.assertTrue(bounded["unknowns"][0]["at_bound"])
            self.assertAlmostEqual(bounded["unknowns"][0]["value"], 1.1, delta=1e-9)
            self.assertEqual(len(bounded["other_costs"]), 2)
            rows = rows_of(table)
            self.assertEqual(set(row["column"] for row in rows), {"q", "p"})
            self.assertFalse(all(each["white"] for each in bounded["columns"]))
            text = run(of_part("pendulum"), "fit", examples / "pendulum.toml", *words, "--bounds",
                       "parameters.length=0.9:1.1")
            self.assertIn("not as independent errors do", text.stdout)
            self.assertIn("at its bound", text.stdout)

    def test_data_that_cannot_be_fitted_are_refused_in_a_line(self):
        with tempfile.TemporaryDirectory() as folder:
            def refused(text, said, *words):
                file = pathlib.Path(folder) / "bad.csv"
                file.write_text(text)
                told = run(of_part("pendulum"), "fit", examples / "pendulum.toml", file, *words)
                self.assertEqual((told.returncode, len(told.stderr.splitlines())), (2, 1), told.stderr)
                self.assertIn(said, told.stderr)

            refused("q,p\n1,2\n", "no column t, the time")
            refused("t,height\n0,1\n", "nothing in it is a column of the run; there are q, p")
            refused("t,q\n0.012345,1\n", "row 2: t = 0.012345 is no node of the run")
            refused("t,q\n0,one\n", "row 2: \"one\" is no number")
            refused("t,q\n0,1\n", "parameters.colour: nothing of that name", "--wrt", "parameters.colour")
            refused("t,q\n0,1\n", "COLUMN=SIGMA", "--sigma", "q")
            refused("t,q\n0,1\n", "no such column of the run", "--sigma", "height=1")
            refused("t,q\n0,1\n", "it has bounds, but is not to be fitted", "--wrt", "initial", "--bounds",
                    "parameters.length=1:2")
            refused("t,q\n0,1\n", "which is not from 2 to 3", "--bounds", "parameters.length=2:3")
            refused("t,q\n-1,1\n", "row 2: t = -1 is before the start of the run")
            refused("t,q\n0,1\n1e7,1\n", "row 3: t = 10000000 is 100000000 steps after the start")
            refused("t,q\n0,1e300\n", "row 2: q = 1e+300 is beyond 1e+100 sigma")
            refused("t,q\n0,nan\n0.1,\n", "all fields that count are empty or NaN")
            refused("t,q\n0,1\n", "--huber: give a positive number, not -1", "--huber", "-1")
            refused("t,q\n0,1\n", "--huber: give a positive number, not nan", "--huber", "nan")
            refused("t,q\n0,1\n", "--sigma q: it is given twice", "--sigma", "q=1,q=2")
            refused("t,q\n0,1\n", "--bounds parameters.length: it is given twice", "--bounds", "parameters.length=0.5:2,parameters.length=0.5:3")
            twice = ("--combination", "a=parameters.length", "--combination", "a=parameters.mass")
            refused("t,q\n0,1\n", "--combination a: it is given twice", *twice)
            refused("", "no header; the first line names t and columns of the run")

    def test_a_fit_has_files_with_a_plot(self):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "fit"
            data = self.measured(folder, "one run", 0.01)
            words = ("--wrt", "parameters.length", "--out", out)
            found = self.fitted(data, data, *words)
            written = {"residuals.csv", "summary.json", "summary.txt", "figures.gp", "plot.svg", "plot.png"}
            self.assertTrue(written <= {each.name for each in out.iterdir()})
            self.assertEqual({pathlib.Path(each).name for each in found["files"]}, written)
            self.assertEqual(json.loads((out / "summary.json").read_text())["unknowns"], found["unknowns"])
            drawn = (out / "plot.svg").read_text()
            for word in ("measured, run 1", "fitted, run 2"):
                self.assertIn(word, drawn)
            # Of other data it is another fit.
            other = self.measured(folder, "another", 0.01, 2)
            told = run(of_part("pendulum"), "fit", examples / "pendulum.toml", other, *words)
            self.assertEqual((told.returncode, len(told.stderr.splitlines())), (2, 1), told.stderr)
            told = run(of_part("pendulum"), "gradient", examples / "pendulum.toml", "--covariance", out / "summary.json", "--set", "time.steps=9")
            self.assertEqual(told.returncode, 0, told.stderr)

    def test_a_sigma_far_below_the_errors_is_told_under_hubers_loss(self):
        words = ("fit", examples / "damped_pendulum.toml", examples / "measured_pendulum.csv", "--wrt",
                 "initial,parameters.length,parameters.damping", "--huber", "1.345")
        self.assertIn("% of the numbers are within --huber sigma", run(of_part("damped_pendulum"), *words, "--sigma", "q=1e-5").stdout)
        self.assertNotIn("within --huber sigma", run(of_part("damped_pendulum"), *words, "--sigma", "q=0.01").stdout)

    def test_data_that_tell_nothing_are_told(self):
        with tempfile.TemporaryDirectory() as folder:
            text = (examples / "measured_pendulum.csv").read_text()
            rows = [row for row in text.splitlines() if not row.startswith("#")]
            late = pathlib.Path(folder) / "late.csv"
            moved = [",".join([f"{float(t) + 900:g}", *rest]) for t, *rest in (row.split(",") for row in rows[1:])]
            late.write_text("\n".join([rows[0], *moved]) + "\n")
            # It swings no more by then, whatever its length is.
            told = run(of_part("damped_pendulum"), "fit", examples / "damped_pendulum.toml", late, "--wrt",
                       "initial,parameters.length", "--json")
            found = json.loads(told.stdout)
            self.assertEqual(found["rank"], 0)
            self.assertEqual([each["deviation"] for each in found["unknowns"]], 3 * [None])

    def test_residuals_are_written_beside_what_was_read_and_never_over_it(self):
        with tempfile.TemporaryDirectory() as folder:
            data = self.measured(folder, "exact", 0.0)
            scene = pathlib.Path(folder) / "scene.toml"
            scene.write_text((examples / "pendulum.toml").read_text())
            before = data.read_bytes(), scene.read_bytes()
            for file, said in ((data, "it is read by this very fit"), (scene, "it is read by this very fit"),
                               (pathlib.Path(folder) / "none" / "res.csv", "it cannot be written"), (folder, "it cannot be written")):
                told = run(of_part("pendulum"), "fit", scene, data, "--wrt", "parameters.length", "--residuals", file)
                self.assertEqual((told.returncode, told.stdout, len(told.stderr.splitlines())), (2, "", 1), told.stderr)
                self.assertIn(said, told.stderr)
            self.assertEqual((data.read_bytes(), scene.read_bytes()), before)

    def test_fits_stay_where_scenes_are_allowed(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "up.csv"
            # It falls upwards: a length below zero would do it.
            file.write_text("t,q\n" + "".join(f"{k / 10},{1.047 + 0.04 * k * k}\n" for k in range(6)))
            found = self.fitted(file, "--wrt", "parameters.length")
            length, = found["unknowns"]
            self.assertGreater(length["value"], 0)
            self.assertTrue(length["at_bound"] or length["value"] > 1e-3, length)
            # Bodies, whose scenes alone say what they allow.
            file.write_text("t,bob.x,bob.z\n0,0.04,-1\n0.5,0.01,-1.2\n1,-0.03,-1.3\n1.5,0,-1.1\n")
            told = run(of_part("bodies"), "fit", examples / "spring_pendulum.toml", file, "--wrt", "parameters", "--json")
            self.assertIn(told.returncode, (0, 3), told.stderr)
            for each in json.loads(told.stdout)["unknowns"]:
                if each["name"].endswith(("length", "mass", "stiffness")):
                    self.assertGreater(each["value"], 0, each)

    def test_what_is_carried_on_is_of_this_system_and_a_covariance(self):
        with tempfile.TemporaryDirectory() as folder:
            data = self.measured(folder, "noisy", 0.01)
            file = pathlib.Path(folder) / "fit.json"
            words = ("gradient", examples / "pendulum.toml", "--set", "time.steps=20", "--covariance", file)
            fitted = self.fitted(data, "--wrt", "parameters.length,initial.momentum")

            def refused(said, change):
                other = json.loads(json.dumps(fitted))
                change(other)
                file.write_text(json.dumps(other))
                told = run(of_part("pendulum"), *words)
                self.assertEqual((told.returncode, len(told.stderr.splitlines())), (2, 1), told.stdout + told.stderr)
                self.assertIn(said, told.stderr)

            refused("what was fitted is kepler", lambda f: f.update(system="kepler"))
            refused("a variance that is negative", lambda f: f["covariance"][0].__setitem__(0, -1))
            refused("is not symmetric", lambda f: f["covariance"][0].__setitem__(1, f["covariance"][0][1] + 1))
            both = [[1, 2], [2, 1]]
            refused("a combination of negative variance", lambda f: f.update(covariance=both))
            refused("ended at its bound", lambda f: f["unknowns"][0].update(at_bound=True))
            refused("is one start among several", lambda f: f["unknowns"][0].update(name="initial.p of run 1"))
            refused("length becomes -1, and is to be positive", lambda f: f["unknowns"][1].update(value=-1))
            file.write_text(json.dumps(fitted))
            told = run(of_part("pendulum"), *words)
            self.assertEqual(told.returncode, 0, told.stderr)
            # Of as many numbers as unknowns nothing tells how large errors are but a sigma.
            one = pathlib.Path(folder) / "one.csv"
            one.write_text("t,q\n1,0.5\n")
            for sigma, code, said in (((), 2, "errors are not known"), (("--sigma", "q=0.01"), 0, "")):
                file.write_text(json.dumps(self.fitted(one, "--wrt", "parameters.length", *sigma)))
                told = run(of_part("pendulum"), *words)
                self.assertEqual(told.returncode, code, told.stderr)
                self.assertIn(said, told.stderr)

    def test_parameters_of_formulas_are_fitted(self):
        with tempfile.TemporaryDirectory() as folder:
            scene, data = examples / "elastic_pendulum.toml", pathlib.Path(folder) / "run"
            short = ("--set", 'initial={position=[1.1,0.8],momentum=[0.1,-0.2]}', "--set", "time.steps=200", "--set",
                     "output.every=5")
            told = run(of_part("formula"), "run", scene, *short, "--out", data)
            self.assertEqual(told.returncode, 0, told.stderr)
            rows = rows_of(data / "trajectory.csv")
            measured = pathlib.Path(folder) / "measured.csv"
            with open(measured, "w") as file:
                file.write("t,r,theta\n" + "".join(f"{row['t']},{row['r']},{row['theta']}\n" for row in rows))
            told = run(of_part("formula"), "fit", scene, measured, *short, "--set", "parameters.k=70", "--set",
                       "parameters.g=9", "--wrt", "parameters.k,parameters.g", "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            for unknown, value in zip(json.loads(told.stdout)["unknowns"], (80, 9.81)):
                self.assertAlmostEqual(unknown["value"], value, delta=1e-9)

    def test_parameters_of_poisson_systems_are_fitted(self):
        with tempfile.TemporaryDirectory() as folder:
            scene, data = examples / "lotka_volterra.toml", pathlib.Path(folder) / "run"
            short = ("--set", "time.steps=300", "--set", "output.every=10")
            told = run(of_part("poisson"), "run", scene, *short, "--out", data)
            self.assertEqual(told.returncode, 0, told.stderr)
            rows = rows_of(data / "trajectory.csv")
            measured = data / "measured.csv"
            with open(measured, "w") as file:
                file.write("t,x,y\n" + "".join(f"{row['t']},{row['x']},{row['y']}\n" for row in rows))
            told = run(of_part("poisson"), "fit", scene, measured, *short, "--set", "parameters.growth=1.1", "--set",
                       "parameters.death=0.9", "--wrt", "parameters.growth,parameters.death", "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            found = json.loads(told.stdout)
            self.assertLess(found["cost"], 1e-20, told.stdout)
            self.assertEqual(len(found["unknowns"]), 2)
            for unknown in found["unknowns"]:
                self.assertAlmostEqual(unknown["value"], 1, delta=1e-9)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
