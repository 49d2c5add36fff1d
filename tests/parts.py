#!/usr/bin/env python3
"""What `./lagroid` builds for a scene, and that it does what the whole program does: parts.py BIN EXAMPLES.

BIN holds lagroid, lagroid-part and parts/pendulum, parts/bodies, parts/spheres, parts/poisson,
parts/formula and parts/files.
"""
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

bin_folder, examples = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
built = ("pendulum", "bodies", "spheres", "poisson", "formula", "files")


def run(program, *words):
    return subprocess.run([str(program), *map(str, words)], capture_output=True, text=True, timeout=120)


def part_of(*words):
    told = run(bin_folder / "lagroid-part", *words)
    assert told.returncode == 0, told.stderr
    return told.stdout.strip()


def of_part(name):
    return bin_folder / "parts" / name / "lagroid"


def rows_of(table):
    with table.open() as text:
        return list(csv.DictReader(text))


def without_times(text):
    result = json.loads(text)
    return {key: value for key, value in result.items() if key not in ("seconds", "program", "machine")}


class Parts(unittest.TestCase):
    def test_every_example_has_one(self):
        listed = {system["name"] for system in json.loads(run(bin_folder / "lagroid", "list", "--json").stdout)}
        found = {scene: part_of("run", scene) for scene in sorted(examples.rglob("*.toml"))}
        self.assertGreater(len(found), 40)
        for scene, part in found.items():
            self.assertTrue(part in listed or part in ("bodies", "spheres", "poisson", "formula", "whole"), f"{scene}: {part}")
        self.assertEqual({"pendulum", "bodies", "spheres", "poisson", "formula", "whole"} - set(found.values()), set())

    def test_they_give_what_the_whole_gives(self):
        for scene in sorted(examples.glob("*.toml")):
            part = part_of("run", scene)
            if part not in built:
                continue
            words = ("run", scene, "--json", "--set", "time.steps=20")
            whole, alone = run(bin_folder / "lagroid", *words), run(of_part(part), *words)
            self.assertEqual(whole.returncode, alone.returncode, f"{scene}: {alone.stderr}")
            self.assertEqual(without_times(whole.stdout), without_times(alone.stdout), str(scene))

    def test_a_part_has_the_laws_of_its_scenes(self):
        for scene in ("elastic_pendulum", "bob_on_a_sphere", "driven_oscillator", "kepler_hamiltonian"):
            told = run(of_part("formula"), "check", examples / f"{scene}.toml", "--samples", "5", "--json")
            self.assertEqual(told.returncode, 0, told.stdout + told.stderr)
            found = json.loads(told.stdout)
            self.assertGreater(sum(len(suite["laws"]) for suite in found["suites"]), 2, scene)
        told = run(of_part("formula"), "check", examples / "elastic_pendulum.toml", "--set", "time.step=5")
        self.assertNotEqual(told.returncode, 0, "steps that do not converge cannot be judged")

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

    def test_gradients_of_composed_steps_tend_to_those_of_the_flow(self):
        def end(*settings):
            told = run(of_part("pendulum"), "gradient", examples / "pendulum.toml", *settings,
                       "--wrt", "initial,parameters.length", "--check", "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            found = json.loads(told.stdout)
            self.assertGreater(found["digits_agreed"], 7)
            return [x for row in found["derivatives"] for x in row]

        exact = end("--set", "time.order=8", "--set", "time.steps=400", "--set", "time.step=0.0075")
        error = [max(abs(a - b) for a, b in zip(end("--set", "time.order=4", "--set", f"time.steps={n}", "--set", f"time.step={3 / n}"),
                                                     exact))
                 for n in (40, 80)]
        self.assertLess(error[1], error[0] / 12)  # 16, of order four

    def test_gradients_of_bodies_and_spheres_are_refused_by_name(self):
        for scene, said in (("spring_pendulum", "this program has no derivatives of runs of bodies"),
                            ("pendulum_chain", 'this program has no derivatives of runs of "pendulum_chain"')):
            told = run(bin_folder / "parts" / "pendulum" / "lagroid-gradient", examples / f"{scene}.toml")
            self.assertEqual(told.returncode, 2, told.stderr)
            self.assertIn(said, told.stderr)

    @unittest.skipUnless((bin_folder / "lagroid-gradient").exists(), "of the whole program, built for the nightly tests")
    def test_gradients_keep_the_velocities_that_scenes_give(self):
        for scene in ("chaplygin_sleigh", "rolling_disk", "rolling_ball", "rolling_ball_reduced"):
            told = run(bin_folder / "lagroid-gradient", examples / f"{scene}.toml", "--set", "time.duration=1.0", "--set",
                       "time.steps=50", "--of", "final.momentum", "--wrt", "initial.velocity,parameters", "--check", "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            self.assertGreater(json.loads(told.stdout)["digits_agreed"], 7, scene)

    def test_gradients_of_poisson_systems(self):
        for scene, of, columns in (("lotka_volterra", "final", 6), ("kirchhoff", "final.state,final.Casimirs,node.20.energy", 16),
                                   ("stochastic_top", "final.state,integral.energy", 6)):
            # The derivatives of the whole program are built for the nightly tests only.
            whole = [bin_folder / "lagroid"] if (bin_folder / "lagroid-gradient").exists() else []
            for program in (of_part("poisson"), *whole):
                told = run(program, "gradient", examples / f"{scene}.toml", "--set", "time.steps=40", "--of", of, "--json",
                           "--check")
                self.assertEqual(told.returncode, 0, told.stderr)
                found = json.loads(told.stdout)
                self.assertEqual(len(found["by"]), columns, scene)
                self.assertGreater(found["digits_agreed"], 8, scene)
        told = run(of_part("poisson"), "gradient", examples / "three_species.toml", "--set", "time.method=projected-midpoint", "--set",
                   "time.steps=40", "--of", "final", "--json", "--check")
        self.assertEqual(told.returncode, 0, told.stderr)
        self.assertGreater(json.loads(told.stdout)["digits_agreed"], 8)
        refused = {("--wrt", "parameters.mass"): "nothing of that name is differentiable here",
                   ("--set", 'event=[{name = "e", when = "x - 1"}]'): "no derivatives through events"}
        for words, why in refused.items():
            told = run(of_part("poisson"), "gradient", examples / "three_species.toml", *words)
            self.assertEqual(told.returncode, 2, told.stdout)
            self.assertIn(why, told.stderr)

    def test_studies_of_motions_that_begin_later(self):
        scene = ("study", examples / "driven_oscillator.toml", "--set", "event=[]", "--set", "time.steps=40", "--set",
                 "time.start=0.7", "--budget", "2", "--methods", "gauss*", "--json")
        told = run(of_part("formula"), *scene)
        self.assertEqual(told.returncode, 0, told.stderr)
        found = json.loads(told.stdout)
        self.assertLess(found["reference"]["uncertainty"], 1e-12)
        # As many steps as fit into the duration, wherever it begins.
        for each in found["runs"]:
            if each["status"] == "converged":
                self.assertAlmostEqual(each["steps"] * each["step"], found["time"], delta=1e-9 * found["time"])
        self.assertLess(min(each["trajectory"] for each in found["runs"] if each["status"] == "converged"), 1e-10)

    def test_gradients_of_formulas(self):
        start = 'initial={position=[1.1,0.8],momentum=[0.1,-0.2]}'
        for settings in (("method=gauss", "order=6"), ("method=lobatto", "order=4"), ("method=midpoint", "order=4")):
            told = run(of_part("formula"), "gradient", examples / "elastic_pendulum.toml", "--set", start, "--set",
                       "time.steps=100", *(word for each in settings for word in ("--set", "time." + each)),
                       "--of", "final.position,final.energy,node.7.theta", "--check", "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            found = json.loads(told.stdout)
            self.assertEqual(found["by"][4:], ["parameters." + name for name in ("g", "k", "length", "m")])
            self.assertGreater(found["digits_agreed"], 8, settings)
        for method in ("type-2", "type-3", "symmetrised"):
            told = run(of_part("formula"), "gradient", examples / "kepler_hamiltonian.toml", "--set", "time.steps=40",
                       "--set", f"time.method={method}", "--of", "final", "--check", "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            self.assertGreater(json.loads(told.stdout)["digits_agreed"], 8, method)
        # A velocity is held, and its momentum is not: a mass decides of it; and columns that are computed.
        told = run(of_part("formula"), "gradient", examples / "elastic_pendulum.toml", "--set", "initial.velocity=[0.3,-0.4]",
                   "--set", "time.steps=60", "--column", "x=r*sin(theta)", "--column", "px=parameters.m*(r'*sin(theta)+x/tan(theta)*theta')",
                   "--of", "final.velocity,final.x,final.px,node.0.p_r", "--check", "--json")
        self.assertEqual(told.returncode, 0, told.stderr)
        found = json.loads(told.stdout)
        self.assertEqual(found["by"], ["initial.r", "initial.theta", "initial.r'", "initial.theta'", "parameters.g", "parameters.k",
                                       "parameters.length", "parameters.m"])
        self.assertGreater(found["digits_agreed"], 8)
        self.assertEqual(found["derivatives"][-1], [0, 0, 1, 0, 0, 0, 0, 0.3])
        for words, why in ((("bob_on_a_sphere.toml",), "with constraints"), (("elastic_pendulum.toml", "--column", "r=theta"), "one of that name"),
                           (("elastic_pendulum.toml", "--column", "y=height"), "it is of parameters.g"),
                           (("elastic_pendulum.toml", "--column", "y"), "NAME=EXPRESSION")):
            told = run(of_part("formula"), "gradient", examples / words[0], *words[1:], "--of", "final")
            self.assertEqual((told.returncode, len(told.stderr.splitlines())), (2, 1), told.stdout + told.stderr)
            self.assertIn(why, told.stderr)

    def checked(self, scene, of):
        """The table of a pendulum's gradients, which differences bear out."""
        told = run(of_part("pendulum"), *scene, "--of", of, "--check", "--json")
        self.assertEqual(told.returncode, 0, told.stderr)
        found = json.loads(told.stdout)
        self.assertGreater(found["digits_agreed"], 7)
        return found

    def ran(self, scene, out):
        """The rows of the run of that scene."""
        done = run(of_part("pendulum"), "run", *scene[1:], "--out", out, "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        return rows_of(out / "trajectory.csv")

    def test_gradients_go_through_events(self):
        kicked = ('event=[{name = "wall", when = "sin(q) - 0.3*cos(2*pi*t)", direction = "falling", kick = ["-0.4*p + 0.1*q^2"]},'
                  '{name = "turn", when = "p", direction = "rising"}]')
        scene = ("gradient", examples / "pendulum.toml", "--set", "time.steps=150", "--set", kicked)
        found = self.checked(scene, "final,events,event.wall.1,node.149.p")
        self.assertIn("event.turn.1.t", found["of"])
        self.assertEqual(found["of"].count("event.wall.1.t"), 1)
        # The run itself says the same of where and when.
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "out"
            rows = self.ran(scene, out)
            value = dict(zip(found["of"], found["values"]))
            self.assertAlmostEqual(value["final.q"], float(rows[-1]["q"]), delta=1e-12)
            self.assertAlmostEqual(value["node.149.p"], float(rows[-2]["p"]), delta=1e-12)
            first = next(row for row in rows_of(out / "events.csv") if row["event"] == "wall")
            self.assertAlmostEqual(value["event.wall.1.t"], float(first["t"]), delta=1e-10)
        # Under another gravity, which depends on how it comes there.
        changed = ('event=[{name = "moon", when = "q - 0.1", direction = "falling", set = ["gravity = 3 + 0.5*p^2 + 0.2*t", "mass = 1.2"], '
                   'kick = ["0.1*q - 0.05*p"]}]')
        scene = ("gradient", examples / "pendulum.toml", "--set", "time.steps=150", "--set", changed)
        found = self.checked(scene, "final,events,node.140.p")
        self.assertGreater(len([name for name in found["of"] if name.startswith("event.moon")]), 1)
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "out"
            value = dict(zip(found["of"], found["values"]))
            self.assertAlmostEqual(value["final.q"], float(self.ran(scene, out)[-1]["q"]), delta=1e-12)
        told = run(of_part("pendulum"), *scene[:4], "--set", changed.replace("1.2", "q - 1"), "--of", "final")
        self.assertEqual((told.returncode, len(told.stderr.splitlines())), (3, 1), told.stderr)
        self.assertIn("mass becomes -0.9, and is to be positive", told.stderr)
        # An end that an event makes: on the wall whatever the start, at a time that depends on it.
        stopped = 'event=[{name = "floor", when = "q", then = "stop"}]'
        told = run(of_part("pendulum"), "gradient", examples / "pendulum.toml", "--set", stopped, "--of", "final.t,final.q",
                   "--check", "--json")
        self.assertEqual(told.returncode, 0, told.stderr)
        found = json.loads(told.stdout)
        self.assertGreater(max(map(abs, found["derivatives"][0])), 0.01)
        self.assertLess(max(map(abs, found["derivatives"][1])), 1e-12)
        # A period does not depend on the mass, for a start whose momentum is zero.
        told = run(of_part("pendulum"), "gradient", examples / "pendulum.toml", "--set", stopped, "--of", "event.floor.1.t",
                   "--set", "initial.momentum=[0]", "--wrt", "parameters.mass,parameters.length", "--json")
        by_mass, by_length = json.loads(told.stdout)["derivatives"][0]
        self.assertLess(abs(by_mass), 1e-12)
        self.assertGreater(by_length, 0.01)
        told = run(of_part("pendulum"), "fit", examples / "pendulum.toml", "--set", stopped, os.devnull)
        self.assertEqual(told.returncode, 2)
        self.assertIn("without events", told.stderr)

    def gradient(self, event, *words):
        told = run(of_part("pendulum"), "gradient", examples / "pendulum.toml", "--set", "time.steps=50", "--set", f"event=[{event}]",
                   *words, "--json")
        self.assertEqual(told.returncode, 0, f"{event}: {told.stderr}")
        return json.loads(told.stdout)

    def test_gradients_find_the_events_that_a_run_finds(self):
        for when in ("q^4 - 0.1", "q^3 - 0.125", "q*2/3 - 0.1", "2*q/3 - 0.2", "(q-0.5)/2/3", "q - _pi/6", "abs(p) - 0.05",
                     "sqrt(q + 2) - 1.3", "2*q+3*q - 0.1", "max(q, p) - 0.2", "t - 0.5", "t - 0.55"):
            event = f'{{name = "x", when = "{when}", kick = ["-0.5*p"], direction = "both"}}'
            found = self.gradient(event, "--of", "final.q,final.p,events", "--wrt", "initial", "--check")
            with tempfile.TemporaryDirectory() as folder:
                out = pathlib.Path(folder) / "out"
                done = run(of_part("pendulum"), "run", examples / "pendulum.toml", "--set", "time.steps=50", "--set",
                           f"event=[{event}]", "--out", out)
                self.assertEqual(done.returncode, 0, f"{when}: {done.stderr}")
                last, rows = rows_of(out / "trajectory.csv")[-1], rows_of(out / "events.csv")
            self.assertEqual(len(found["of"]) - 2, len(rows), when)
            self.assertAlmostEqual(found["values"][0], float(last["q"]), delta=1e-12, msg=when)
            self.assertAlmostEqual(found["values"][1], float(last["p"]), delta=1e-12, msg=when)
            self.assertGreater(found["digits_agreed"], 6, when)

    def test_gradients_say_of_events_what_a_run_says(self):
        wall = '{name = "x", when = "q - 0.3", then = "stop"}'
        self.assertGreater(self.gradient(wall, "--of", "final", "--wrt", "initial", "--check")["digits_agreed"], 7)
        found = self.gradient('{name = "x", when = "q - 0.5 + 0/0", then = "stop"}', "--of", "final.q")
        self.assertIn("no finite number at 51 of 51 nodes", found["notes"][0])
        # Beside a graze: the runs of the wider differences have other events.
        found = self.gradient('{name = "x", when = "q + 1.046"}', "--of", "events,final", "--check")
        self.assertGreater(found["digits_agreed"], 6)
        # Draws that never come to the wall are no ends of this kind.
        found = self.gradient('{name = "x", when = "q + 1.0", then = "stop"}', "--of", "final.t", "--deviations", "initial.q=0.05",
                              "--draws", "200")
        self.assertGreater(found["draws"]["failed"], 20)
        # Draws through more or fewer events than the run have ends all the same.
        passed = self.gradient('{name = "x", when = "q + 1.0", direction = "falling", kick = ["0.1"]}', "--of", "final",
                               "--deviations", "initial.q=0.05", "--draws", "200")["draws"]
        self.assertEqual(passed["failed"], 0)
        self.assertGreater(passed["through_other_events"], 20)
        names = '{name = "k", when = "q - 0.5"}, {name = "k.1", when = "q - 0.2"}'
        found = self.gradient(names, "--of", "event.k.1.1.t,event.k.1.t", "--check")
        self.assertLess(found["values"][1], found["values"][0])
        for event, said in {
            '{name = "k", when = "q - 0.5"}, {name = "k", when = "q - 0.2"}': "k",
            '{name = "x", when = "q", body = "x"}': "body",
            '{name = "x", when = "q - 0.3", kick = ["-2*p"]}': "follow their own changes",
        }.items():
            told = run(of_part("pendulum"), "gradient", examples / "pendulum.toml", "--set", "time.steps=50", "--set",
                       f"event=[{event}]")
            self.assertNotEqual(told.returncode, 0, event)
            self.assertEqual(len(told.stderr.splitlines()), 1, told.stderr)
            self.assertIn(said, told.stderr)
        # An end that would be at once from beside the start has a derivative by what leaves it zero there: half a period.
        ended = '{name = "x", when = "p", then = "stop"}'
        told = run(of_part("pendulum"), "gradient", examples / "pendulum.toml", "--set", "time.steps=50", "--set",
                   f"event=[{ended}]", "--wrt", "initial.p")
        self.assertEqual((told.returncode, len(told.stderr.splitlines())), (2, 1), told.stderr)
        self.assertIn("is zero at the start", told.stderr)
        found = self.gradient(ended, "--of", "final.t", "--wrt", "parameters.length,initial.q", "--check")
        self.assertGreater(found["digits_agreed"], 6)
        self.assertGreater(found["derivatives"][0][1], 1)
        # How often that has happened which is zero at the start depends on where one looks from; what follows does not.
        turning = '{name = "x", when = "p"}'
        told = run(of_part("pendulum"), "gradient", examples / "pendulum.toml", "--set", f"event=[{turning}]", "--of",
                   "event.x.1.t")
        self.assertEqual((told.returncode, told.stdout, len(told.stderr.splitlines())), (2, "", 1), told.stderr)
        self.assertIn("is zero at the start", told.stderr)
        self.assertGreater(self.gradient(turning, "--of", "final", "--check")["digits_agreed"], 6)
        # The time to the other side, by what leaves the start as it is.
        self.assertGreater(self.gradient(turning, "--of", "event.x.1.t", "--wrt", "parameters.length,initial.q",
                                         "--check")["digits_agreed"], 6)

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
            ("--of", "final.heat"): "nothing of that name is differentiable",
            ("--of", "node.51.position"): "a node is a number from 0 to 50",
            ("--of", "energy"): "ask for final.NAME",
            ("--wrt", "parameters.quadrature"): "nothing of that name is differentiable",
            ("--wrt", "mass"): "initial.NAME or parameters.NAME",
            ("--set", "time.mode=adaptive", "--set", "time.without_root=controlled"): "time.without_root: ",
            ("--set", "time.mode=adaptive", "--set", "parameters.quadrature=midpoint", "--of", "integral.q"):
                "integrals over steps whose sizes vary have no derivative here",
            ("--set", "solver.method=ceres"): "solver: ",
            ("--set", "time.method=extrapolation", "--set", "time.tolerance=1e-9", "--set", 'event=[{name = "x", when = "q"}]'): "by equal variational steps",
            ("--set", 'event=[{name = "x", when = "q", at = "maximum"}]'): "not of minima and maxima",
            ("--set", 'event=[{name = "x", when = "q", set = ["gravity = heat"]}]'): "there are t, q, p, energy",
            ("--set", 'event=[{name = "x", when = "q", set = ["quadrature = 1"]}]'): "which is no parameter that is a number",
            ("--set", 'event=[{name = "x", when = "heat"}]'): "there are t, q, p, energy",
            ("--set", 'event=[{name = "x", when = "q - 9"}]', "--of", "events"): "none has happened",
            ("--set", 'event=[{name = "x", when = "q"}]', "--of", "event.x.9.t"): "has happened 1 times",
            ("--set", 'event=[{name = "x", when = "q"}]', "--of", "event.y.1.t"): "the events are x",
            ("--set", 'event=[{name = "x", when = "q"}]', "--of", "integral.q"): "ask for final.NAME",
            ("--set", 'event=[{name = "x", when = "q"}]', "--of", "node.3.t"): "depend on nothing",
            ("--set", 'event=[{name = "x", when = "q", then = "stop"}]', "--of", "node.40"): "before this node",
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
