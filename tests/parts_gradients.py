#!/usr/bin/env python3
"""`lagroid gradient` of systems and of scenes on spheres, by every kind of step: parts_gradients.py BIN EXAMPLES, as parts.py."""
import json
import pathlib
import sys
import tempfile
import unittest

from parts import examples, of_part, rows_of, run


class Gradients(unittest.TestCase):
    def test_gradients_of_steps_that_vary_and_of_splittings(self):
        for scene, settings in (("pendulum_adaptive", ()), ("pendulum", ("--set", "time.mode=controlled")), ("pendulum", ("--set", "time.method=splitting", "--set", "time.order=4"))):
            told = run(of_part("pendulum"), "gradient", examples / f"{scene}.toml", "--set", "time.steps=30", *settings, "--check",
                       "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            found = json.loads(told.stdout)
            self.assertGreater(found["digits_agreed"], 7)
            self.assertEqual("final.t" in found["of"], "time.method=splitting" not in settings)
        told = run(of_part("pendulum"), "gradient", examples / "pendulum_adaptive.toml", "--set", "time.steps=1", "--of", "final.time",
                   "--json")
        found = json.loads(told.stdout)
        self.assertEqual(found["values"], [0.2], "the first step has the size that was given")
        self.assertEqual(set(found["derivatives"][0]), {0.0})
        told = run(of_part("pendulum"), "gradient", examples / "pendulum_adaptive.toml", "--set", "parameters.quadrature=trapezoid")
        self.assertEqual(told.returncode, 3, told.stderr)
        self.assertIn("has no root", told.stderr)

    def test_growth_of_errors_does_not_depend_on_units(self):
        grew = [json.loads(run(of_part("pendulum"), "gradient", examples / "pendulum.toml", "--set", f"parameters.mass={mass}", "--of",
                               "final.q", "--wrt", "initial.q", "--json").stdout)["growth"] for mass in ("1.0", "1e200", "1e-200")]
        self.assertGreater(grew[0], 5)
        for other in grew[1:]:
            self.assertAlmostEqual(other, grew[0], delta=1e-6 * grew[0])

    def test_gradients_in_transformed_time(self):
        words = (of_part("kepler").with_name("lagroid-gradient"), examples / "kepler.toml", "--set", "time.mode=transformed", "--set", "time.steps=50")
        for order in (2, 6):
            told = run(*words, "--set", f"time.order={order}", "--of", "final.position,final.t,node.20.momentum", "--check", "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            found = json.loads(told.stdout)
            self.assertGreater(found["digits_agreed"], 8)
            self.assertIn("parameters.strength", found["by"])
        told = run(*words, "--of", "integral.position")
        self.assertEqual((told.returncode, len(told.stderr.splitlines())), (2, 1), told.stderr)

    def test_gradients_of_adaptive_steps_that_go_on(self):
        words = ("gradient", examples / "pendulum_adaptive.toml", "--set", "parameters.quadrature=trapezoid", "--set", "time.steps=30")
        told = run(of_part("pendulum"), *words, "--set", "time.without_root=constant", "--check", "--json")
        self.assertEqual(told.returncode, 0, told.stderr)
        found = json.loads(told.stdout)
        self.assertGreater(found["digits_agreed"], 7)
        self.assertTrue(any("for want of a root" in note for note in found["notes"]), found["notes"])
        told = run(of_part("pendulum"), *words, "--set", "time.without_root=controlled")
        self.assertEqual((told.returncode, len(told.stderr.splitlines())), (2, 1), told.stderr)

    def test_gradients_of_explicit_steps(self):
        runge_kutta = ("--set", "time.method=runge-kutta", "--set", "time.steps=60", "--check", "--json")
        for system in ("pendulum", "damped_pendulum"):
            told = run(of_part(system), "gradient", examples / f"{system}.toml", *runge_kutta)
            self.assertEqual(told.returncode, 0, told.stderr)
            found = json.loads(told.stdout)
            self.assertGreater(found["digits_agreed"], 8)
            self.assertIn("parameters.length", found["by"])
        extrapolated = ("gradient", examples / "pendulum.toml", "--set", "time.method=extrapolation", "--set", "time.steps=20", "--check", "--json")
        for tolerance, fewest in (("1e-4", 2), ("1e-13", 7)):
            told = run(of_part("pendulum"), *extrapolated, "--set", f"time.tolerance={tolerance}")
            self.assertEqual(told.returncode, 0, told.stderr)
            found = json.loads(told.stdout)
            self.assertGreater(found["digits_agreed"], fewest)
            self.assertTrue(any("inner steps" in note for note in found["notes"]), found["notes"])

    def test_gradients_of_moser_and_veselovs_steps(self):
        words = (of_part("rigid_body").with_name("lagroid-gradient"), examples / "rigid_body_moser_veselov.toml", "--set", "time.steps=40")
        for order in (2, 6, 10):
            told = run(*words, "--set", f"time.order={order}", "--of", "final,node.10.momentum,integral.M1", "--check", "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            found = json.loads(told.stdout)
            self.assertGreater(found["digits_agreed"], 9)
            self.assertIn("parameters.inertia.2", found["by"])
        # The axis of the middle moment is known by differences of the moments.
        sphere = (*words, "--set", "parameters.inertia=[2.0, 2.0, 2.0]")
        found = json.loads(run(*sphere, "--check", "--json").stdout)
        self.assertGreater(found["digits_agreed"], 9)
        self.assertFalse(any(name.startswith("parameters") for name in found["by"]))
        told = run(*sphere, "--wrt", "parameters.inertia.1")
        self.assertEqual((told.returncode, len(told.stderr.splitlines())), (2, 1), told.stderr)
        self.assertIn("all moments of inertia are equal", told.stderr)
        # Some of these runs have no step.
        told = run(*words, "--of", "final.M1", "--set", "time.step=2.5", "--deviations", "initial.M2=0.5", "--draws", "100", "--json")
        self.assertEqual(told.returncode, 0, told.stderr)
        self.assertGreater(json.loads(told.stdout)["draws"]["refused"], 0)

    def test_gradients_of_explicit_steps_go_through_events(self):
        kicked = 'event=[{name = "low", when = "q", direction = "falling", kick = ["0.1*p + 0.02*q"]}]'
        stopped = 'event=[{name = "low", when = "q - t/100", then = "stop", count = 3}]'
        with tempfile.TemporaryDirectory() as folder:
            for method in ("splitting", "runge-kutta"):
                for event in (kicked, stopped):
                    words = (examples / "pendulum.toml", "--set", f"time.method={method}", "--set", event, "--set", "time.steps=200")
                    told = run(of_part("pendulum"), "gradient", *words, "--of", "events,event.low.2,final", "--check", "--json")
                    self.assertEqual(told.returncode, 0, told.stderr)
                    found = json.loads(told.stdout)
                    self.assertEqual((found["contradicted"], found["untold"]), ([], []))
                    self.assertGreater(found["digits_agreed"], 8)
                    self.assertEqual(found["of"][:3], [f"event.low.{k}.t" for k in (1, 2, 3)])
                    out = pathlib.Path(folder) / f"{method}-{event == kicked}"
                    self.assertEqual(run(of_part("pendulum"), "run", *words, "--out", out).returncode, 0)
                    rows = json.loads((out / "summary.json").read_text())["events"]["rows"]
                    for row, value in zip(rows, found["values"][:3], strict=True):
                        self.assertAlmostEqual(row["t"], value, delta=1e-12)
                # A node after a kick, without the end.
                told = run(of_part("pendulum"), "gradient", examples / "pendulum.toml", "--set", f"time.method={method}", "--set", kicked,
                           "--set", "time.steps=60", "--of", "node.40.q", "--wrt", "parameters.length", "--check", "--json")
                self.assertGreater(json.loads(told.stdout)["digits_agreed"], 8, told.stderr)
        for more, said in ((('event=[{name = "low", when = "q", set = ["gravity = 2"]}]',), "by equal variational steps alone"),
                           ((kicked, "--set", "time.method=extrapolation", "--set", "time.tolerance=1e-8"), "splittings and runge-kutta")):
            told = run(of_part("pendulum"), "gradient", examples / "pendulum.toml", "--set", "time.method=splitting", "--set", *more)
            self.assertEqual((told.returncode, len(told.stderr.splitlines())), (2, 1), told.stderr)
            self.assertIn(said, told.stderr)

    def test_gradients_and_fits_go_through_events_by_composed_steps(self):
        kicked = 'event=[{name = "low", when = "q", direction = "falling", kick = ["0.1*p + 0.02*q"]}]'
        changed = kicked.replace("}]", ', set = ["gravity = 1 + 0.3*p^2 + 0.01*t"]}]')
        steps = ("--set", "time.steps=200", "--set", "time.order=6")
        with tempfile.TemporaryDirectory() as folder:
            for event in (kicked, changed):
                words = (examples / "pendulum.toml", *steps, "--set", event)
                told = run(of_part("pendulum"), "gradient", *words, "--of", "events,event.low.2,final", "--check", "--json")
                self.assertEqual(told.returncode, 0, told.stderr)
                found = json.loads(told.stdout)
                self.assertEqual((found["contradicted"], found["untold"]), ([], []))
                self.assertGreater(found["digits_agreed"], 8)
                out = pathlib.Path(folder) / f"{event == kicked}"
                self.assertEqual(run(of_part("pendulum"), "run", *words, "--set", "parameters.length=1.1", "--out", out).returncode, 0)
                fit = run(of_part("pendulum"), "fit", words[0], out / "trajectory.csv", *words[1:], "--of", "q", "--wrt",
                          "parameters.length", "--json")
                if event == changed:
                    self.assertEqual((fit.returncode, len(fit.stderr.splitlines())), (2, 1), fit.stderr)
                    self.assertIn("or set numbers", fit.stderr)
                    continue
                self.assertEqual(fit.returncode, 0, fit.stderr)
                self.assertLess(abs(json.loads(fit.stdout)["unknowns"][0]["value"] - 1.1), 1e-8, fit.stdout)

    def test_gradients_of_reduced_runs(self):
        program = of_part("kepler").with_name("lagroid-gradient")
        steps = ("--set", "time.steps=100")
        reduced = (program, examples / "kepler_reduced.toml", *steps)
        for more in ((), ("--set", "reduce=rotations"), ("--set", "time.order=4")):
            told = run(*reduced, *more, "--check", "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            self.assertGreater(json.loads(told.stdout)["digits_agreed"], 8, more)
        # They are those of the full run.
        full = json.loads(run(program, examples / "kepler.toml", *steps, "--json").stdout)["derivatives"]
        for row, other in zip(json.loads(run(*reduced, "--json").stdout)["derivatives"], full, strict=True):
            for x, y in zip(row, other, strict=True):
                self.assertAlmostEqual(x, y, delta=1e-9 * (1 + abs(y)))
        # Through events, too, the third of which is next to a node, past which wide differences take it.
        passing = ("--set", "time.steps=700", "--set", 'event=[{name = "up", when = "y - 0.1*x"}]', "--of", "events,final", "--check", "--json")
        through = [json.loads(run(program, examples / f"{scene}.toml", *passing).stdout) for scene in ("kepler_reduced", "kepler")]
        for found in through:
            self.assertEqual((len(found["of"]), found["contradicted"], found["untold"]), (8, [], []))
        for row, other in zip(through[0]["derivatives"], through[1]["derivatives"], strict=True):
            for x, y in zip(row, other, strict=True):
                self.assertAlmostEqual(x, y, delta=1e-8 * (1 + abs(y)))
        told = run(program, examples / "kepler_reduced.toml", "--set", 'event=[{name = "up", when = "y", kick = ["px", "py"]}]')
        self.assertEqual((told.returncode, len(told.stderr.splitlines())), (2, 1), told.stderr)
        self.assertIn("nothing can be added to the momentum", told.stderr)
        # Where the table turns it is not the same everywhere.
        ball = (of_part("rolling_ball").with_name("lagroid-gradient"), examples / "rolling_ball_reduced.toml", *steps, "--of", "final")
        found = json.loads(run(*ball, "--check", "--json").stdout)
        self.assertGreater(found["digits_agreed"], 8)
        self.assertIn("parameters.radius", found["by"])
        self.assertNotIn("parameters.plate_rate", found["by"])
        told = run(*ball, "--wrt", "parameters.plate_rate")
        self.assertEqual((told.returncode, len(told.stderr.splitlines())), (2, 1), told.stderr)
        self.assertIn('with another value, "translations" is no symmetry', told.stderr)
        told = run(*reduced, "--set", "solver.method=ceres")
        self.assertEqual((told.returncode, len(told.stderr.splitlines())), (2, 1), told.stderr)
        self.assertIn("reduced runs by equal steps", told.stderr)

    def test_where_differences_tell_nothing_it_says_so(self):
        # At the start nothing has moved: differences are the derivatives to rounding.
        words = ("gradient", examples / "pendulum.toml", "--set", "time.steps=5", "--of", "node.0.position", "--check")
        found = json.loads(run(of_part("pendulum"), *words, "--json").stdout)
        self.assertTrue(found["within_rounding"])
        self.assertLess(found["digits_agreed"], 13)
        self.assertIn("their rounding leaves", run(of_part("pendulum"), *words).stdout)

    def test_fits_go_between_the_nodes_of_steps_that_vary(self):
        with tempfile.TemporaryDirectory() as folder:
            for mode, step in (("controlled", 0.02), ("adaptive", 0.02)):
                more = ("--set", f"time.mode={mode}", "--set", f"time.step={step}", "--set", "time.steps=120", "--set",
                        "parameters.quadrature=midpoint")
                out = pathlib.Path(folder) / mode
                told = run(of_part("pendulum"), "run", examples / "pendulum.toml", *more, "--set", "parameters.length=1.1", "--out", out)
                self.assertEqual(told.returncode, 0, told.stderr)
                told = run(of_part("pendulum"), "fit", examples / "pendulum.toml", out / "trajectory.csv", *more, "--wrt",
                           "parameters.length,initial.momentum", "--json")
                self.assertEqual(told.returncode, 0, told.stderr)
                found = json.loads(told.stdout)
                # Nodes of the run with the other length are times between those of the fitted one, and at the solution they are its own.
                self.assertLess(abs(found["unknowns"][1]["value"] - 1.1), 1e-8, told.stdout)

    def test_what_was_fitted_is_carried_on_with_its_covariance(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "fit.json"
            told = run(of_part("damped_pendulum"), "fit", examples / "damped_pendulum.toml", examples / "measured_pendulum.csv",
                       "--wrt", "initial,parameters.length,parameters.damping", "--sigma", "q=0.01", "--json")
            file.write_text(told.stdout)
            fitted = json.loads(told.stdout)
            scene = ("gradient", examples / "damped_pendulum.toml", "--set", "time.steps=300", "--of", "final,node.0.position")
            told = run(of_part("damped_pendulum"), *scene, "--covariance", file, "--draws", "400", "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            found = json.loads(told.stdout)
            self.assertEqual(found["by"], [each["name"] for each in fitted["unknowns"]])
            # The start is the fitted one, as well known as the fit says.
            self.assertAlmostEqual(found["values"][-1], fitted["unknowns"][0]["value"], delta=1e-12)
            self.assertAlmostEqual(found["covariance"][-1][-1] / fitted["covariance"][0][0], 1, delta=1e-9)
            for i in range(2):  # five deviations of a variance of 400 draws
                self.assertAlmostEqual(found["draws"]["covariance"][i][i] / found["covariance"][i][i], 1, delta=5 * (2 / 399) ** 0.5)
            # As independent errors of the same sizes they would be others.
            errors = ",".join(f"{each['name']}={each['deviation']}" for each in fitted["unknowns"])
            apart = json.loads(run(of_part("damped_pendulum"), *scene, "--deviations", errors, "--json").stdout)
            self.assertGreater(abs(apart["covariance"][0][0] / found["covariance"][0][0] - 1), 0.1)
            for text, said in (("{}", "it has no unknowns"), ('{"unknowns":[{"name":"parameters.length","value":1,"deviation":null}]}', "is not told")):
                file.write_text(text)
                told = run(of_part("damped_pendulum"), *scene, "--covariance", file)
                self.assertEqual((told.returncode, len(told.stderr.splitlines())), (2, 1), told.stderr)
                self.assertIn(said, told.stderr)

    def test_gradients_of_costs_of_boundary_values(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder) / "swing.toml"
            scene.write_text('system = "pendulum"\n[time]\nduration = 1.0\nsteps = 40\n[boundary]\n'
                             "start = { position = [0.1] }\nend = { position = [0.8] }\n")
            told = run(of_part("pendulum"), "gradient", scene, "--check", "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            found = json.loads(told.stdout)
            self.assertEqual(found["of"], ["cost"])
            self.assertEqual(found["by"][:3], ["boundary.start.0", "boundary.end.0", "parameters.mass"])
            self.assertGreater(found["digits_agreed"], 8)
            self.assertAlmostEqual(found["derivatives"][0][2], found["values"][0], delta=1e-9)  # the cost is linear in the mass, 1
            told = run(of_part("pendulum"), "gradient", scene, "--of", "final.position")
            self.assertEqual(told.returncode, 2)
            self.assertIn("ask for cost", told.stderr)

    def gradient_on_spheres(self, scene, *words, code=0):
        told = run(of_part("spheres"), "gradient", examples / f"{scene}.toml", *words, "--json")
        self.assertEqual(told.returncode, code, told.stdout + told.stderr)
        return json.loads(told.stdout)

    def test_gradients_of_scenes_on_spheres_by_every_method(self):
        methods = ("rattle", "lie-euler", "crouch-grossman-2", "crouch-grossman-3", "commutator-free-4", "munthe-kaas-4", "munthe-kaas-54",
                   "euler", "runge-kutta-4")
        chains = [("pendulum_chain", f"time.method={method}", f"time.form={form}") for method in methods
                  for form in ("velocities", "momenta")] + [("pendulum_chain", "time.order=6", "parameters.masses=1.5")]
        learned = [("learned_hamiltonian", f"time.method={method}") for method in methods[1:]]
        for scene, *settings in chains + learned:
            found = self.gradient_on_spheres(scene, "--set", "time.steps=40", "--of", "final,integral.energy", "--check",
                                             *(word for each in settings for word in ("--set", each)))
            self.assertGreater(found["digits_agreed"], 8, settings)
        self.assertIn("parameters.model.0", found["by"])

    def test_gradients_on_spheres_hold_inner_steps(self):
        for scene, method in (("pendulum_chain", "extrapolation"), ("pendulum_chain", "munthe-kaas-54"),
                              ("learned_hamiltonian", "extrapolation"), ("learned_hamiltonian", "munthe-kaas-54")):
            found = self.gradient_on_spheres(scene, "--set", "time.steps=10", "--set", "time.step=0.05", "--set",
                                             f"time.method={method}", "--set", "time.tolerance=1e-13", "--of", "final", "--check")
            self.assertGreater(found["digits_agreed"], 8, (scene, method))
            self.assertIn("hold the sizes of the inner steps", found["notes"][0])
        self.gradient_on_spheres("pendulum_chain_adaptive", "--set", "time.steps=5")

    def test_gradients_of_chains_are_of_the_scene_as_it_is_edited(self):
        scene = ("--set", "time.steps=50")
        found = self.gradient_on_spheres("pendulum_chain", *scene, "--of", "final.z3,final.w3x", "--wrt", "parameters.masses.0")
        plain = self.gradient_on_spheres("pendulum_chain", *scene, "--set", "parameters.lengths=0.8", "--of", "final.z3", "--wrt",
                                         "parameters.lengths")
        self.assertEqual(plain["by"], ["parameters.lengths"])
        with tempfile.TemporaryDirectory() as folder:
            def last(*settings):
                told = run(of_part("spheres"), "run", examples / "pendulum_chain.toml", *scene, *settings, "--set", "output.every=1",
                           "--out", out := pathlib.Path(tempfile.mkdtemp(dir=folder)) / "run")
                self.assertEqual(told.returncode, 0, told.stdout + told.stderr)
                row = rows_of(out / "trajectory.csv")[-1]
                return float(row["z3"]), float(row["w3x"])

            def difference(key, *values):
                below, above = (last("--set", f"parameters.{key}={value}") for value in values)
                return [(b - a) / 2e-5 for a, b in zip(below, above)]

            for exact, close in zip(found["derivatives"], difference("masses", "[0.99999,0.5,2]", "[1.00001,0.5,2]")):
                self.assertAlmostEqual(exact[0], close, delta=1e-7)
            self.assertAlmostEqual(plain["derivatives"][0][0], difference("lengths", "0.79999", "0.80001")[0], delta=1e-7)

    def test_scenes_on_spheres_say_what_has_no_derivative(self):
        for words, why in ((("--set", 'event=[{name = "e", when = "x1"}]'), "no derivatives through events"),
                           (("--wrt", "parameters.links"), "nothing of that name is differentiable here")):
            told = run(of_part("spheres"), "gradient", examples / "pendulum_chain.toml", *words)
            self.assertEqual(told.returncode, 2, told.stdout)
            self.assertIn(why, told.stderr)

    def test_numbers_and_starts_of_chains_are_fitted(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = (examples / "pendulum_chain.toml", "--set", "time.steps=400")
            told = run(of_part("spheres"), "run", *scene, "--set", "parameters.lengths=[1.02,0.7,0.4]", "--set",
                       "initial.theta=[1.93,1.4,2.6]", "--out", pathlib.Path(folder) / "run")
            self.assertEqual(told.returncode, 0, told.stderr)
            told = run(of_part("spheres"), "fit", scene[0], pathlib.Path(folder) / "run" / "trajectory.csv", *scene[1:], "--of",
                       "x3,y3,z3,q1x", "--wrt", "initial.q1,initial.w1,parameters.lengths.0", "--json")
            self.assertEqual(told.returncode, 0, told.stdout + told.stderr)
            found = {unknown["name"]: unknown["value"] for unknown in json.loads(told.stdout)["unknowns"]}
            self.assertAlmostEqual(found["parameters.lengths.0"], 1.02, delta=1e-8)
            self.assertAlmostEqual(found["initial.q1.south"], 0.03, delta=1e-8)
            self.assertAlmostEqual(found["initial.q1.east"], 0, delta=1e-8)
            file = pathlib.Path(folder) / "fit.json"
            file.write_text(told.stdout)
            carried = self.gradient_on_spheres("pendulum_chain", *scene[1:], "--covariance", file, "--of", "final.position")
            self.assertEqual(len(carried["covariance"]), 9)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
