#!/usr/bin/env python3
"""Parameters found again from what was sampled of exact motions: identification.py BIN DATA DRAWS.

BIN holds parts/formula and parts/poisson. DATA/identification.json has samples of flows that were computed to twenty
digits by other programs. With errors, so many DRAWS of them are fitted.
"""
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

bin_folder, data_folder = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
draws = int(sys.argv[3])
cases = {case["id"]: case for case in json.loads((data_folder / "identification.json").read_text())["cases"]}


def chain_scene(count, order, step, start):
    """Bobs in a plane by their absolute angles, of `start` = (angles, rates); all rods have the length l."""
    angles = [f"a{i + 1}" for i in range(count)]
    below = ["(" + "+".join(f"m{k + 1}" for k in range(i, count)) + ")" for i in range(count)]
    terms = [f"{below[max(i, j)]}*l{i + 1}*l{j + 1}*{angles[i]}'*{angles[j]}'*cos({angles[i]}-{angles[j]})" + ("/2" if i == j else "")
             for i in range(count) for j in range(i, count)]
    terms += [f"{below[i]}*g*l{i + 1}*cos({angles[i]})" for i in range(count)]
    return (f'system = "lagrangian"\n[lagrangian]\ncoordinates = {json.dumps(angles)}\nl = "{" + ".join(terms)}"\n'
            f"[initial]\nposition = {start[0]}\nvelocity = {start[1]}\n"
            f'[time]\nmethod = "gauss"\norder = {order}\nstep = {step}\nsteps = 10\n')


top_scene = """system = "heavy_top_bracket"
[initial]
state = [0.3, -0.28, 2.4, 0.6, 0.0, 0.8]
[time]
step = 0.0125
steps = 10
order = 8
"""
body_scene = """system = "euler_top"
[initial]
state = [0.8, 0.6, 1.2]
[time]
step = 0.03333333333333333
steps = 10
order = 8
"""
rates = [word for i in range(3) for word in ("--column", f"w{i + 1}=M{i + 1}/parameters.inertia.{i}")]


class Fitted(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, case, columns, noise=None):
        """Samples of a case as a file, columns as (group, factors, names)."""
        samples = [(name, [float(row[i]) * factors[i] for row in case["samples"][group]])
                   for group, factors, names in columns for i, name in enumerate(names)]
        lines = ["t," + ",".join(name for name, _ in samples)]
        for k in range(len(samples[0][1])):
            values = [column[k] + (noise() if noise else 0) for _, column in samples]
            lines.append(",".join(repr(x) for x in [k * float(case["step"]), *values]))
        file = self.folder / "samples.csv"
        file.write_text("\n".join(lines) + "\n")
        return file

    def fit(self, part, scene, data, parameters, *words):
        file = self.folder / "scene.toml"
        file.write_text(scene + "[parameters]\n" + "".join(f"{name} = {value}\n" for name, value in parameters.items()))
        told = subprocess.run([str(bin_folder / "parts" / part / "lagroid-gradient"), "fit", str(file), str(data), "--json", *words],
                              capture_output=True, text=True, timeout=120)
        self.assertEqual(told.returncode, 0, told.stderr + told.stdout[-500:])
        found = json.loads(told.stdout)
        found["value"] = {each["name"]: each["value"] for each in found["unknowns"] + found["combinations"]}
        found["deviation"] = {each["name"]: each["deviation"] for each in found["unknowns"] + found["combinations"]}
        return found

    def assert_found(self, found, expected, tolerance=1e-11):
        for name, value in expected.items():
            self.assertLess(abs(found["value"][name] - value), tolerance, f"{name}: {found['value'][name]}")
            self.assertIsNotNone(found["deviation"][name], name)


def guesses(true, share, seed):
    draw = random.Random(seed)
    return {name: [x * (1 + share * draw.uniform(-1, 1)) for x in value] if isinstance(value, list) else
            value * (1 + share * draw.uniform(-1, 1)) for name, value in true.items()}


class DoublePendulum(Fitted):
    case = cases["C-ident-doublependulum"]
    true = {name: float(value) for name, value in case["params_true"].items()}
    scene = chain_scene(2, 10, 0.025, ([0.9, -0.4], [0.0, 0.5]))
    told = {"rho": 0.375, "lambda": 0.8, "kappa": 9.81}
    combinations = [word for text in ("rho=parameters.m2/(parameters.m1+parameters.m2)", "lambda=parameters.l2/parameters.l1",
                                      "kappa=parameters.g/parameters.l1") for word in ("--combination", text)]
    columns = (("theta", (1, 1), ("a1", "a2")), ("thetadot", (1, 1), ("a1'", "a2'")), ("momentum", (1, 1), ("p_a1", "p_a2")))

    def test_angles_tell_three_of_five(self):
        data = self.write(self.case, self.columns)
        for share, seed in ((0.03, 1), (0.3, 2), (0.3, 3)):
            for of in ("a1,a2", "a1,a2,a1',a2'"):
                found = self.fit("formula", self.scene, data, guesses(self.true, share, seed), "--wrt", "parameters", "--of", of,
                                 *self.combinations)
                self.assertEqual((found["rank"], len(found["null_space"])), (3, 2))
                self.assert_found(found, self.told)
                self.assertEqual(set(found["undetermined"]), {"parameters.m1, parameters.m2, all by one factor",
                                                              "parameters.g, parameters.l1, parameters.l2, all by one factor"})
                page = (data_folder.parent.parent / "docs" / "fit.md").read_text()
                self.assertTrue(all(f"not told by these data: {each}\n" in page for each in found["undetermined"]))
                self.assertEqual([found["deviation"][f"parameters.{name}"] for name in self.true], [None] * 5)

    def test_starts_are_found_with_them(self):
        data = self.write(self.case, self.columns[:1])
        found = self.fit("formula", self.scene.replace("0.9, -0.4", "1.0, -0.3"), data, guesses(self.true, 0.2, 4), "--wrt",
                         "initial,parameters", *self.combinations)
        self.assertEqual(found["rank"], 7)
        self.assert_found(found, {**self.told, "initial.a1": 0.9, "initial.a2": -0.4, "initial.a1'": 0, "initial.a2'": 0.5})

    def test_momenta_tell_one_more(self):
        data = self.write(self.case, (self.columns[0], self.columns[2]))
        found = self.fit("formula", self.scene, data, guesses(self.true, 0.3, 5), "--wrt", "parameters", *self.combinations)
        self.assertEqual(found["rank"], 4)
        self.assert_found(found, self.told)
        (unseen,) = found["null_space"]  # masses fall as the square by which lengths grow
        by = {each["name"].split(".")[1]: dx / each["value"] for each, dx in zip(found["unknowns"], unseen)}
        for name, factor in {"m1": -2, "m2": -2, "l1": 1, "l2": 1, "g": 1}.items():
            self.assertAlmostEqual(by[name] / by["l1"], factor, delta=1e-6)

    def test_with_lengths_known_masses_are_told_as_far_as_can_be(self):
        known = {**guesses(self.true, 0.3, 6), **{name: self.true[name] for name in ("l1", "l2", "g")}}
        masses = ("--wrt", "parameters.m1,parameters.m2", *self.combinations[:2])
        found = self.fit("formula", self.scene, self.write(self.case, self.columns[:1]), known, *masses)
        self.assertEqual(found["rank"], 1)
        self.assert_found(found, {"rho": 0.375})
        data = self.write(self.case, (self.columns[0], self.columns[2]))
        found = self.fit("formula", self.scene, data, known, *masses)
        self.assertEqual((found["rank"], found["undetermined"]), (2, []))
        self.assert_found(found, {"parameters.m1": 1, "parameters.m2": 0.6})

    def test_what_limits_it_is_the_order_of_the_method(self):
        data = self.write(self.case, self.columns[:1])
        off = {}
        for order in (2, 4, 6, 8):
            for step in (0.05, 0.025):
                scene = chain_scene(2, order, step, ([0.9, -0.4], [0.0, 0.5]))
                if order == 2:
                    scene = scene.replace("gauss", "midpoint")
                found = self.fit("formula", scene, data, self.true, "--wrt", "parameters", *self.combinations)
                off[order, step] = abs(found["value"]["rho"] - 0.375)
        for order in (2, 4, 6):
            self.assertGreater(math.log2(off[order, 0.05] / off[order, 0.025]), order - 0.4)
        self.assertGreater(off[2, 0.025], 1e-5)
        self.assertLess(off[8, 0.025], 1e-11)


class HeavyTop(Fitted):
    case = cases["C-ident-top"]
    true = {"inertia": [1, 1.4, 0.6], "weight": [0.2, 0, 2]}
    ratios = [word for name in ("inertia.1", "inertia.2", "weight.0", "weight.1", "weight.2")
              for word in ("--combination", f"{name}=parameters.{name}/parameters.inertia.0")]
    told = {"inertia.1": 1.4, "inertia.2": 0.6, "weight.0": 0.2, "weight.1": 0, "weight.2": 2}

    def test_rates_tell_all_but_one_scale(self):
        data = self.write(self.case, (("Omega", (1, 1, 1), ("w1", "w2", "w3")), ("Gamma", (1, 1, 1), ("g1", "g2", "g3"))))
        for share, seed in ((0.03, 1), (0.3, 2), (0.3, 7)):
            parameters = guesses(self.true, share, seed)
            found = self.fit("poisson", top_scene, data, parameters, "--wrt", "initial,parameters", *rates, *self.ratios)
            self.assertEqual(found["rank"], 11)
            self.assert_found(found, self.told)
            (named,) = found["undetermined"]
            self.assertIn("parameters.inertia.0, parameters.inertia.1, parameters.inertia.2, parameters.weight.0", named)
            self.assertIn("all by one factor", named)

    def test_momenta_tell_all(self):
        data = self.write(self.case, (("Omega", (1, 1.4, 0.6), ("M1", "M2", "M3")), ("Gamma", (1, 1, 1), ("g1", "g2", "g3"))))
        for seed in range(2, 20, 3):
            parameters = guesses(self.true, 0.3, seed)
            parameters["weight"][1] = 0.1
            found = self.fit("poisson", top_scene, data, parameters, "--wrt", "parameters")
            self.assertEqual((found["rank"], found["undetermined"]), (6, []))
            self.assert_found(found, {f"parameters.{name}.{i}": x for name, all_of_it in self.true.items()
                                      for i, x in enumerate(all_of_it)})


class FreeBody(Fitted):
    case = cases["C-ident-freebody"]
    true = {"inertia": [1, 2, 3]}

    def test_rates_tell_ratios(self):
        data = self.write(self.case, (("Omega", (1, 1, 1), ("w1", "w2", "w3")),))
        ratios = [word for i in (1, 2) for word in ("--combination", f"r{i}=parameters.inertia.{i}/parameters.inertia.0")]
        for seed in range(4, 8):
            found = self.fit("poisson", body_scene, data, guesses(self.true, 0.3, seed), "--wrt", "initial,parameters", *rates, *ratios)
            self.assertEqual(found["rank"], 5)
            self.assert_found(found, {"r1": 2, "r2": 3})

    def test_momenta_tell_differences_of_reciprocals(self):
        data = self.write(self.case, (("M", (1, 1, 1), ("M1", "M2", "M3")),))
        differences = [word for i in (1, 2)
                       for word in ("--combination", f"d{i}=1/parameters.inertia.0-1/parameters.inertia.{i}")]
        found = self.fit("poisson", body_scene, data, guesses(self.true, 0.3, 1), "--wrt", "parameters", *differences, "--combination",
                         "ratio=parameters.inertia.1/parameters.inertia.0")
        self.assertEqual(found["rank"], 2)
        self.assert_found(found, {"d1": 1 / 2, "d2": 2 / 3})
        self.assertIsNone(found["deviation"]["ratio"])
        (unseen,) = found["null_space"]
        moments = [each["value"] for each in found["unknowns"]]
        by = [dx / x**2 for dx, x in zip(unseen, moments)]
        self.assertLess(max(by) - min(by), 1e-6 * abs(by[0]))

    def test_both_tell_all(self):
        data = self.write(self.case, (("Omega", (1, 1, 1), ("w1", "w2", "w3")), ("M", (1, 1, 1), ("M1", "M2", "M3"))))
        found = self.fit("poisson", body_scene, data, guesses(self.true, 0.3, 2), "--wrt", "initial,parameters", *rates)
        self.assertEqual(found["rank"], 6)
        self.assert_found(found, {f"parameters.inertia.{i}": i + 1 for i in range(3)})


class TenMassesAndInertias(Fitted):
    def test_from_samples_without_errors(self):
        # Eight bobs by angles and momenta, of a motion by shorter steps; a top by its rates, one moment given.
        start = ([0.5, -0.3, 0.4, 0.2, -0.5, 0.1, 0.6, -0.2], [0.0] * 8)
        true = {f"m{i + 1}": 0.5 + 0.1 * i for i in range(8)}
        others = {**{f"l{i + 1}": 0.3 for i in range(8)}, "g": 9.81}
        fine = self.folder / "fine.toml"
        scene = chain_scene(8, 10, 0.0025, start).replace("steps = 10", "steps = 400")
        fine.write_text(scene + "[output]\nevery = 20\n[parameters]\n" + "".join(f"{k} = {v}\n" for k, v in {**true, **others}.items()))
        told = subprocess.run([str(bin_folder / "parts" / "formula" / "lagroid"), "run", str(fine), "--out", str(self.folder / "fine")],
                              capture_output=True, text=True, timeout=120)
        self.assertEqual(told.returncode, 0, told.stderr)
        of = ",".join(f"{kind}a{i + 1}" for kind in ("", "p_") for i in range(8))
        found = self.fit("formula", chain_scene(8, 10, 0.005, start), self.folder / "fine" / "trajectory.csv",
                         {**guesses(true, 0.1, 1), **others}, "--wrt", ",".join(f"parameters.{name}" for name in true), "--of", of)
        self.assertEqual(found["rank"], 8)
        self.assert_found(found, {f"parameters.{name}": x for name, x in true.items()}, 1e-8)
        case = cases["C-ident-top"]
        data = self.write(case, (("Omega", (1, 1, 1), ("w1", "w2", "w3")), ("Gamma", (1, 1, 1), ("g1", "g2", "g3"))))
        known = {"inertia": [1, 1.2, 0.7], "weight": [0.2, 0, 2]}
        found = self.fit("poisson", top_scene, data, known, "--wrt", "initial,parameters.inertia.1,parameters.inertia.2", *rates)
        self.assert_found(found, {"parameters.inertia.1": 1.4, "parameters.inertia.2": 0.6}, 1e-8)


class Errors(Fitted):
    def test_solutions_are_as_far_off_as_their_covariance_says(self):
        case, true, sigma = cases["C-ident-top"], HeavyTop.true, 1e-3
        unknowns = [f"parameters.{name}.{i}" for name in true for i in range(3)]
        words = ["--wrt", "parameters", "--sigma", ",".join(f"{name}={sigma}" for name in ("M1", "M2", "M3", "g1", "g2", "g3"))]
        expected = [x for all_of_it in true.values() for x in all_of_it]
        distances = []
        for seed in range(draws):
            draw = random.Random(seed)
            data = self.write(case, (("Omega", (1, 1.4, 0.6), ("M1", "M2", "M3")), ("Gamma", (1, 1, 1), ("g1", "g2", "g3"))),
                              lambda: draw.gauss(0, sigma))
            found = self.fit("poisson", top_scene.replace("0.0125", "0.05"), data, true, *words)
            # The deviations are given: of chi squared the scale is one.
            covariance = [[x / found["scale"] ** 2 for x in row] for row in found["covariance"]]
            off = [found["value"][name] - x for name, x in zip(unknowns, expected)]
            distances.append(sum(x * y for x, y in zip(off, solved(covariance, off))))
        mean = sum(distances) / draws
        self.assertLess(abs(mean - 6), 3 * math.sqrt(12 / draws), mean)


def solved(matrix, right):
    """Gauss' elimination, of a positive matrix."""
    rows = [[*row, x] for row, x in zip(matrix, right)]
    n = len(rows)
    for k in range(n):
        for i in range(k + 1, n):
            by = rows[i][k] / rows[k][k]
            rows[i] = [x - by * y for x, y in zip(rows[i], rows[k])]
    out = [0.0] * n
    for k in reversed(range(n)):
        out[k] = (rows[k][n] - sum(rows[k][j] * out[j] for j in range(k + 1, n))) / rows[k][k]
    return out


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
