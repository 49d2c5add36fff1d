#!/usr/bin/env python3
"""`lagroid gradient` of steps that vary, of explicit ones, of reduced runs and of boundary values: parts_gradients.py BIN EXAMPLES, as parts.py."""
import json
import math
import pathlib
import sys
import tempfile
import unittest

from parts import examples, of_part, rows_of, run


def turned(rotation, x):
    """A vector, turned by a rotation vector (Rodrigues)."""
    angle = math.hypot(*rotation)
    k = [each / angle for each in rotation]
    along = sum(a * b for a, b in zip(k, x))
    cross = [k[(i + 1) % 3] * x[(i + 2) % 3] - k[(i + 2) % 3] * x[(i + 1) % 3] for i in range(3)]
    return [a * math.cos(angle) + b * math.sin(angle) + c * along * (1 - math.cos(angle)) for a, b, c in zip(x, cross, k)]


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
                           ((kicked, "--set", "time.order=4", "--set", "time.method=variational"), "splittings and runge-kutta"),
                           ((kicked, "--set", "time.method=extrapolation", "--set", "time.tolerance=1e-8"), "splittings and runge-kutta")):
            told = run(of_part("pendulum"), "gradient", examples / "pendulum.toml", "--set", "time.method=splitting", "--set", *more)
            self.assertEqual((told.returncode, len(told.stderr.splitlines())), (2, 1), told.stderr)
            self.assertIn(said, told.stderr)

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

    def test_gradients_of_scenes_of_bodies(self):
        # Free bodies and tops, chains and closed loops, springs and dampers, rolling and steering, a support that moves.
        for scene in ("figure_eight", "foucault", "rolling_balls", "six_bar", "snakeboard", "spring_pendulum", "steering", "three_links",
                      "tops", "tumbling_book", "two_ways_to_roll", "upside_down"):
            told = run(of_part("bodies"), "gradient", examples / f"{scene}.toml", "--set", "time.steps=20", "--check", "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            self.assertGreater(json.loads(told.stdout)["digits_agreed"], 8, scene)

    def test_gradients_of_bodies_by_controlled_steps(self):
        more = ("--set", "time.mode=controlled", "--set", "time.step=0.02", "--set", "time.steps=60")
        told = run(of_part("bodies"), "gradient", examples / "figure_eight.toml", *more, "--of", "final.position,final.energy,final.t",
                   "--check", "--json")
        self.assertEqual(told.returncode, 0, told.stderr)
        found = json.loads(told.stdout)
        self.assertGreater(found["digits_agreed"], 8)
        self.assertGreater(max(abs(x) for x in found["derivatives"][found["of"].index("final.t")]), 1e-3)
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "eight"
            told = run(of_part("bodies"), "run", examples / "figure_eight.toml", *more, "--set", "output.every=1", "--set",
                       "body.1.mass=1.1", "--out", out)
            self.assertEqual(told.returncode, 0, told.stderr)
            told = run(of_part("bodies"), "fit", examples / "figure_eight.toml", out / "trajectory.csv", *more, "--wrt",
                       "parameters.b.mass", "--of", "a.x,a.y,b.x,b.y,c.x,c.y", "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            # Its nodes are at other times than those of the scene; the fit goes between them.
            self.assertLess(abs(json.loads(told.stdout)["unknowns"][0]["value"] - 1.1), 1e-8, told.stdout)

    def test_gradients_of_bodies_go_through_events(self):
        # The sling is switched off, and the ground ends the run.
        words = ("gradient", examples / "trebuchet.toml", "--of", "events,final,event.release.1.stone.pz,node.100.stone.x", "--wrt",
                 "parameters.stone.mass,parameters.beam.mass,parameters.beam.inertia.1", "--check", "--json")
        told = run(of_part("bodies"), *words)
        self.assertEqual(told.returncode, 0, told.stderr)
        found = json.loads(told.stdout)
        self.assertGreater(found["digits_agreed"], 8)
        # At rest the sling would be released at once, were the start another one.
        told = run(of_part("bodies"), *words[:3], "events", "--wrt", "initial.stone.px")
        self.assertEqual(told.returncode, 2, told.stdout)
        self.assertIn('initial.stone.px: the function of event "release" is zero at the start', told.stderr)
        # Nobody names it: of the start, that is left out.
        told = run(of_part("bodies"), *words[:3], "events", "--wrt", "initial", "--check", "--json")
        self.assertEqual(told.returncode, 0, told.stderr)
        found = json.loads(told.stdout)
        self.assertIn("initial.stone.x", found["by"])
        self.assertNotIn("initial.stone.px", found["by"])
        self.assertGreater(found["digits_agreed"], 7)
        (left_out,) = [note for note in found["notes"] if "left out" in note]
        self.assertIn("initial.stone.px, ", left_out)
        self.assertIn('event "release" is zero at the start', left_out)
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "trebuchet"
            told = run(of_part("bodies"), "run", examples / "trebuchet.toml", "--out", out)
            self.assertEqual(told.returncode, 0, told.stderr)
            rows = json.loads((out / "summary.json").read_text())["events"]["rows"]
            self.assertEqual([row["event"] for row in rows], ["release", "ground"])
            for row, name in zip(rows, ("event.release.1.t", "event.ground.1.t")):
                self.assertAlmostEqual(row["t"], found["values"][found["of"].index(name)], delta=1e-11)

            # Two bodies strike each other: two events of one function, and a fit through them.
            scene = pathlib.Path(folder) / "impact.toml"
            scene.write_text("""
[[body]]
kind = "point"
name = "a"
mass = 1.0
position = [0, 0, 0]
velocity = [1, 0.1, 0]
[[body]]
kind = "rigid"
name = "b"
mass = 2.0
inertia = [0.2, 0.25, 0.3]
position = [1, 0.2, 0]
angular_velocity = [0.1, 1, 0.2]
[[effect]]
kind = "spring"
name = "spring"
between = ["ground", "b"]
points = [[1.5, 0, 0], [0.1, 0, 0]]
stiffness = 3.0
length = 0.4
[time]
step = 0.02
steps = 80
[[event]]
name = "a is struck"
when = "(b.x - a.x)^2 + (b.y - a.y)^2 + (b.z - a.z)^2 - 0.09"
direction = "falling"
body = "a"
kick = ["-0.9*a.px", "0.1*b.py", "0"]
[[event]]
name = "b is struck"
when = "(b.x - a.x)^2 + (b.y - a.y)^2 + (b.z - a.z)^2 - 0.09"
direction = "falling"
body = "b"
kick = ["0.9*a.px", "-0.1*b.py", "0", "0.02*a.px", "0", "0"]
""")
            told = run(of_part("bodies"), "gradient", scene, "--of", "events,final,node.70.b.x", "--check", "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            self.assertGreater(json.loads(told.stdout)["digits_agreed"], 8)
            told = run(of_part("bodies"), "run", scene, "--set", "effect.0.stiffness=3.3", "--set", "output.every=1", "--out",
                       out / "struck")
            self.assertEqual(told.returncode, 0, told.stderr)
            told = run(of_part("bodies"), "fit", scene, out / "struck" / "trajectory.csv", "--wrt", "parameters.spring.stiffness",
                       "--of", "a.x,a.y,b.x,b.y,b.z", "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            self.assertLess(abs(json.loads(told.stdout)["unknowns"][0]["value"] - 3.3), 1e-8, told.stdout)
            for more, said in ((("time.mode=controlled",), "time scale"), (('event.0.set=["spring.stiffness = 2"]',), "by equal variational steps alone"),
                               (('event=[{name = "most", when = "a.x", at = "maximum"}]',), "not of minima and maxima")):
                told = run(of_part("bodies"), "gradient", scene, *(word for each in more for word in ("--set", each)))
                self.assertEqual(told.returncode, 2, told.stdout + told.stderr)
                self.assertEqual(len(told.stderr.strip().splitlines()), 1, told.stderr)
                self.assertIn(said, told.stderr)

    def test_fits_go_through_events_that_are_zero_at_the_start(self):
        # At rest the sling would be released at once, were the start another one; with another mass it stays at rest.
        release = ('event=[{name = "release", when = "stone.px - stone.pz", direction = "rising", switch_off = ["sling"]}]')
        scene = (examples / "trebuchet.toml", "--set", release, "--set", "time.steps=700", "--set", "output.every=1")
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "thrown"
            told = run(of_part("bodies"), "run", *scene, "--set", "body.1.mass=2.2", "--out", out)
            self.assertEqual(told.returncode, 0, told.stderr)
            self.assertEqual(len(json.loads((out / "summary.json").read_text())["events"]["rows"]), 1)
            words = ("fit", scene[0], out / "trajectory.csv", *scene[1:], "--of", "stone.x,stone.z", "--wrt")
            told = run(of_part("bodies"), *words, "parameters.stone.mass", "--json")
            self.assertEqual(told.returncode, 0, told.stdout + told.stderr)
            self.assertLess(abs(json.loads(told.stdout)["unknowns"][0]["value"] - 2.2), 1e-8, told.stdout)
            told = run(of_part("bodies"), *words, "initial.stone.px,parameters.stone.mass")
            self.assertEqual((told.returncode, len(told.stderr.splitlines())), (2, 1), told.stdout + told.stderr)
            self.assertIn('initial.stone.px: the function of event "release" is zero at the start', told.stderr)

    def test_gradients_by_the_numbers_of_most_joints_and_effects(self):
        scene = pathlib.Path(__file__).parent / "data" / "many_bodies.toml"
        told = run(of_part("bodies"), "gradient", scene, "--check", "--json")
        self.assertEqual(told.returncode, 0, told.stderr)
        found = json.loads(told.stdout)
        self.assertEqual(len(found["by"]), 96)
        self.assertGreater(found["digits_agreed"], 8)

    def test_gradients_of_bodies_are_of_the_scene_as_it_is_edited(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder) / "fall.toml"
            scene.write_text('[[body]]\nkind = "point"\nname = "stone"\nmass = 2.0\nposition = [0, 0, 0]\nvelocity = [0, 0, 3]\n'
                             '[[effect]]\nname = "weight"\nkind = "gravity"\nacceleration = [0, 0, -9.81]\n'
                             '[[effect]]\nkind = "drag"\nmotion = 0.4\n[time]\nstep = 0.1\nsteps = 10\n')
            told = run(of_part("bodies"), "gradient", scene, "--of", "final.stone.z,final.stone.pz", "--wrt",
                       "initial.stone.pz,parameters.stone.mass,parameters.weight.acceleration.2,parameters.effect.1.motion", "--check",
                       "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            found = json.loads(told.stdout)
            self.assertGreater(found["digits_agreed"], 10)
            told = run(of_part("bodies"), "run", scene, "--set", "body.0.mass=2.0001", "--out", pathlib.Path(folder) / "heavier")
            self.assertEqual(told.returncode, 0, told.stderr)
            last = (pathlib.Path(folder) / "heavier" / "trajectory.csv").read_text().split()[-1].split(",")
            self.assertAlmostEqual((float(last[3]) - found["values"][0]) / 1e-4, found["derivatives"][0][1], delta=1e-4)

    def test_gradients_of_composed_steps_of_bodies(self):
        told = run(of_part("bodies"), "gradient", examples / "three_links.toml", "--set", "time.steps=10", "--set", "time.order=6", "--of",
                   "final.momentum,final.position", "--wrt", "parameters", "--check", "--json")
        self.assertEqual(told.returncode, 0, told.stderr)
        self.assertGreater(json.loads(told.stdout)["digits_agreed"], 8)

    def test_places_of_joints_and_what_nobody_wrote_have_derivatives(self):
        for scene, steps, numbers in (("three_links", 40, ("joint.0.place", "joint.1.place", "joint.2.place", "effect.0.acceleration")),
                                      ("trebuchet", 700, ("beam.pivot", "effect.0.acceleration")), ("six_bar", 20, ("joint.3.place.0",))):
            told = run(of_part("bodies"), "gradient", examples / f"{scene}.toml", "--set", f"time.steps={steps}", "--of", "final.position,final.momentum", "--wrt",
                       ",".join(f"parameters.{number}" for number in numbers), "--check", "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            found = json.loads(told.stdout)
            self.assertEqual(found["contradicted"], [])
            self.assertGreater(found["digits_agreed"], 8, scene)
            self.assertGreater(max(abs(x) for row in found["derivatives"] for x in row), 1e-3)
        # By a place of a joint both of its points move: together with all other joints and all starts, the whole scene does.
        told = run(of_part("bodies"), "gradient", examples / "three_links.toml", "--set", "time.steps=40", "--of", "final.upper.x,final.upper.px",
                   "--wrt", "initial.position,parameters.joint.0.place.0,parameters.joint.0.points.0", "--json")
        self.assertEqual((told.returncode, len(told.stderr.splitlines())), (2, 1), told.stderr)
        self.assertIn("by NAME.place both points of a joint move", told.stderr)

    def test_places_of_joints_move_together(self):
        attitude, arm, by = (0.4, -0.3, 0.8), (0.3, -0.2, 0.5), (0.02, 0.01, -0.015)
        at = turned(attitude, arm)
        with tempfile.TemporaryDirectory() as folder:
            scene, out = pathlib.Path(folder) / "hung.toml", pathlib.Path(folder) / "moved"
            scene.write_text(f"""
[[body]]
kind = "rigid"
name = "plate"
mass = 1.3
inertia = [0.2, 0.25, 0.3]
position = [0, 0, 0]
attitude = {list(attitude)}
[[joint]]
kind = "ball"
name = "pin"
between = ["ground", "plate"]
points = [{at}, {list(arm)}]
[[effect]]
kind = "gravity"
[time]
step = 0.01
steps = 60
[output]
every = 1
""")
            # Each of the three numbers of the pin in space changes all numbers of its point in the plate, which is turned.
            moved = [x + y for x, y in zip(at, by)]
            in_plate = [x + y for x, y in zip(arm, turned([-x for x in attitude], by))]
            told = run(of_part("bodies"), "run", scene, "--set", f"joint.0.points=[{moved},{in_plate}]", "--out", out)
            self.assertEqual(told.returncode, 0, told.stderr)
            told = run(of_part("bodies"), "fit", scene, out / "trajectory.csv", "--wrt", "parameters.pin.place", "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            unknowns = json.loads(told.stdout)["unknowns"]
            self.assertEqual([each["name"] for each in unknowns], [f"parameters.pin.place.{k}" for k in range(3)])
            for unknown, expected in zip(unknowns, moved):
                self.assertAlmostEqual(unknown["value"], expected, delta=1e-8)

    def test_numbers_of_two_tables_of_one_name_are_told_apart(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder) / "twice.toml"
            scene.write_text("""
[[body]]
kind = "rigid"
name = "plate"
mass = 1.3
inertia = [0.2, 0.25, 0.3]
position = [0, 0, 1]
[[body]]
kind = "chain"
name = "rope"
links = 2
mass = 0.2
length = 0.5
on = "plate"
at = [0.1, 0, 0]
[[effect]]
kind = "force"
name = "rope"
body = "plate"
at = [0, 0.2, 0]
force = [0, 0, 1]
[time]
step = 0.01
steps = 30
""")
            words = ("gradient", scene, "--of", "final.position,final.spin", "--wrt")
            found = {}
            for name in ("rope.at.0", "effect.0.at.0"):
                told = run(of_part("bodies"), *words, f"parameters.{name}", "--check", "--json")
                self.assertEqual(told.returncode, 0, told.stderr)
                found[name] = json.loads(told.stdout)
                self.assertEqual(found[name]["contradicted"], [])
            self.assertNotEqual(found["rope.at.0"]["derivatives"], found["effect.0.at.0"]["derivatives"])

    def test_numbers_that_tear_joints_have_no_derivative(self):
        for scene, number, why in (("three_links", "joint.0.points.0.0", "a scene with another one is refused (joint.0.points"),
                                   ("six_bar", "joint.0.axis.0", "equations of the joints that depend on others would not")):
            told = run(of_part("bodies"), "gradient", examples / f"{scene}.toml", "--wrt", f"parameters.{number}")
            self.assertEqual(told.returncode, 2, told.stdout)
            self.assertIn(why, told.stderr)
            # Asked for with all others it is left out, and told.
            told = run(of_part("bodies"), "gradient", examples / f"{scene}.toml", "--set", "time.steps=5", "--of", "final.energy",
                       "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            found = json.loads(told.stdout)
            # One note for each reason, of which one is that number's.
            left_out = [note for note in found["notes"] if "left out" in note]
            self.assertLessEqual(len(left_out), 2)
            (of_number,) = [note for note in left_out if f"parameters.{number}, " in note]
            self.assertIn(why, of_number)
            self.assertNotIn(f"parameters.{number}", found["by"])
        told = run(of_part("bodies"), "gradient", examples / "close_encounters.toml")
        self.assertEqual(told.returncode, 2, told.stdout)
        self.assertIn("no derivatives through events by controlled steps", told.stderr)

    def test_numbers_of_bodies_are_fitted(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = (examples / "spring_pendulum.toml", "--set", "time.steps=200")
            told = run(of_part("bodies"), "run", *scene, "--set", "effect.1.stiffness=32", "--set", "body.0.mass=1.1", "--out", folder)
            self.assertEqual(told.returncode, 0, told.stderr)
            told = run(of_part("bodies"), "fit", *scene[:1], pathlib.Path(folder) / "trajectory.csv", *scene[1:], "--wrt",
                       "parameters.effect.1.stiffness,parameters.bob.mass", "--json")
            self.assertEqual(told.returncode, 0, told.stdout + told.stderr)
            found = [unknown["value"] for unknown in json.loads(told.stdout)["unknowns"]]
            self.assertAlmostEqual(found[0], 32, delta=32e-9)
            self.assertAlmostEqual(found[1], 1.1, delta=1e-9)

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
