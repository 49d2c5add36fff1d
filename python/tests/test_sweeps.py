"""Sweeps by the program, and their columns."""

import tempfile
import unittest
from pathlib import Path

import lagroid
import numpy as np
from data import EXAMPLES

SWEEP = f"""
[scene]
file = "{EXAMPLES}/pendulum.toml"
time.steps = 50

[design]
kind = "grid"

[[vary]]
key = "initial.position.0"
from = -1.0
to = 1.0
count = 5

[keep]
final = ["position"]
series = ["q"]
"""


class Sweeps(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.file = Path(self.folder.name) / "sweep.toml"
        self.file.write_text(SWEEP)
        self.out = Path(self.folder.name) / "out"

    def test_members_are_runs(self) -> None:
        found = lagroid.sweep(self.file, out=self.out, threads=1)
        self.assertEqual((len(found), found.keys), (5, ["initial.position.0"]))
        np.testing.assert_allclose(found["initial.position.0"], np.linspace(-1, 1, 5))
        for i, start in enumerate(found["initial.position.0"]):
            run = lagroid.run(
                EXAMPLES / "pendulum.toml", set={"time.steps": 50, "initial.position": [start]}
            )
            self.assertAlmostEqual(found["final/q"][i], run.final.position[0], places=12)
            np.testing.assert_allclose(found["series/q"][i], run["q"], atol=1e-12)
        self.assertIn("final/q", found.columns)
        again = lagroid.Sweep.read(self.out)
        np.testing.assert_array_equal(again["final/q"], found["final/q"])
        with self.assertRaises(lagroid.DataError):
            again["final/nothing"]
        with self.assertRaisesRegex(lagroid.OutputError, "holds no sweep"):
            lagroid.Sweep.read(EXAMPLES)

    def test_settings_and_mistakes(self) -> None:
        self.assertEqual(len(lagroid.sweep(self.file, out=self.out, set={"vary.0.count": 3})), 3)
        with self.assertRaisesRegex(lagroid.SceneError, "vary.0.cuont"):
            lagroid.sweep(self.file, out=self.out, set={"vary.0.cuont": 3})


if __name__ == "__main__":
    unittest.main()
