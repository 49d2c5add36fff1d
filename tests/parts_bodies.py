#!/usr/bin/env python3
"""`lagroid gradient` and `lagroid fit` of scenes of bodies: parts_bodies.py BIN EXAMPLES, as parts.py."""
import json
import math
import pathlib
import sys
import tempfile
import unittest

from parts import examples, of_part, run


def turned(rotation, x):
    """A vector, turned by a rotation vector (Rodrigues)."""
    angle = math.hypot(*rotation)
    k = [each / angle for each in rotation]
    along = sum(a * b for a, b in zip(k, x))
    cross = [k[(i + 1) % 3] * x[(i + 2) % 3] - k[(i + 2) % 3] * x[(i + 1) % 3] for i in range(3)]
    return [a * math.cos(angle) + b * math.sin(angle) + c * along * (1 - math.cos(angle)) for a, b, c in zip(x, cross, k)]


def projected_bars(inertia, *bars):
    """The bodies of a scene, each of (name, mass, place along x, velocity), with what joints allow of their velocities."""
    return "project_velocities = true\n" + "".join(
        f'[[body]]\nkind = "rigid"\nname = "{name}"\nmass = {mass}\ninertia = {inertia}\n'
        f"position = [{at}, 0, 0]\nvelocity = {velocity}\n" for name, mass, at, velocity in bars)


class Bodies(unittest.TestCase):
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
        # By one of its points alone a joint is torn, and the message says by what both of them move.
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

    def test_velocities_that_a_joint_stops_are_projected_away(self):
        # A bar is welded to the ground, beside a body that flies: of its velocity nothing is left but rounding.
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder) / "welded.toml"
            scene.write_text(
                projected_bars([0.1, 0.2, 0.3], ("bar", 1.0, 0.5, [0.3, 0.1, 0]), ("stone", 1.0, 3, [0.3, 0.1, 0])) +
                '[[joint]]\nkind = "weld"\nbetween = ["ground", "bar"]\npoints = [[0, 0, 0], [-0.5, 0, 0]]\n'
                '[[effect]]\nkind = "gravity"\n[time]\nstep = 0.01\nsteps = 10\n')
            told = run(of_part("bodies"), "gradient", scene, "--of", "final.bar.px,final.stone.px", "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            at_rest, flying = json.loads(told.stdout)["values"]
            self.assertLess(abs(at_rest), 1e-14)
            self.assertAlmostEqual(flying, 0.3, delta=1e-14)
            told = run(of_part("bodies"), "gradient", scene, "--of", "final.bar.px", "--wrt", "parameters.bar.mass", "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            self.assertLess(abs(json.loads(told.stdout)["derivatives"][0][0]), 1e-12)
            told = run(of_part("bodies"), "gradient", scene, "--set", "project_velocities=false")
            self.assertEqual((told.returncode, len(told.stderr.splitlines())), (2, 1), told.stderr)
            self.assertIn("project_velocities = true", told.stderr)

    def test_places_on_which_a_plane_motion_hardly_depends_are_checked(self):
        # Two bars are welded together and fly in a plane: off it the place of their joint has no effect but rounding.
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder) / "bars.toml"
            scene.write_text(
                projected_bars([0.2, 0.2, 0.3], ("a", 1.0, 0, [1, 0, 0]), ("b", 3.0, 1, [-1, 2, 0])) +
                '[[joint]]\nkind = "weld"\nbetween = ["a", "b"]\npoints = [[0.5, 0, 0], [-0.5, 0, 0]]\n'
                '[time]\nstep = 0.01\nsteps = 100\n')
            told = run(of_part("bodies"), "gradient", scene, "--of", "final.a.x", "--wrt",
                       "parameters.joint.0.place,parameters.a.mass", "--check", "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            found = json.loads(told.stdout)
            self.assertEqual((found["contradicted"], found["untold"]), ([], []))

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


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
