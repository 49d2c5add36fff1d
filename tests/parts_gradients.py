#!/usr/bin/env python3
"""`lagroid gradient` of steps that vary, of splittings and of boundary values: parts_gradients.py BIN EXAMPLES, as parts.py."""
import json
import pathlib
import sys
import tempfile
import unittest

from parts import examples, of_part, run


class Gradients(unittest.TestCase):
    def test_gradients_of_steps_that_vary_and_of_splittings(self):
        for scene, settings in (("pendulum_adaptive", ()), ("pendulum", ("--set", "time.method=splitting", "--set", "time.order=4"))):
            told = run(of_part("pendulum"), "gradient", examples / f"{scene}.toml", "--set", "time.steps=30", *settings, "--check",
                       "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            found = json.loads(told.stdout)
            self.assertGreater(found["digits_agreed"], 7)
            self.assertEqual("final.t" in found["of"], scene == "pendulum_adaptive")
        told = run(of_part("pendulum"), "gradient", examples / "pendulum_adaptive.toml", "--set", "time.steps=1", "--of", "final.time",
                   "--json")
        found = json.loads(told.stdout)
        self.assertEqual(found["values"], [0.2], "the first step has the size that was given")
        self.assertEqual(set(found["derivatives"][0]), {0.0})
        told = run(of_part("pendulum"), "gradient", examples / "pendulum_adaptive.toml", "--set", "parameters.quadrature=trapezoid")
        self.assertEqual(told.returncode, 3, told.stderr)
        self.assertIn("has no root", told.stderr)

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


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
