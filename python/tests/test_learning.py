"""Learning Hamiltonians from trajectories."""

import tempfile
import unittest
from pathlib import Path

import lagroid
import numpy as np


class Learning(unittest.TestCase):
    def test_a_pendulum_is_found(self) -> None:
        data = lagroid.trajectories(count=60, points=5, duration=0.2)
        self.assertEqual((len(data), data.states.shape, data.bodies), (60, (60, 5, 6), 1))
        learned = lagroid.learn(data, "polynomial:1", starts=1, iterations=40)
        self.assertLess(learned.mse, 1e-15)
        np.testing.assert_allclose(learned.mass, [[1.0]], atol=1e-5)
        self.assertEqual(learned.history.shape[1], 4)
        held_out = lagroid.trajectories(count=10, points=5, duration=1.0, seed=9)
        measures = learned.measure(held_out)
        self.assertLess(measures.rms[-1], 1e-5)
        z = held_out.states[0]
        follow = learned.follow(z[0], held_out.interval * np.arange(1, 5))
        np.testing.assert_allclose(follow, z[1:], atol=1e-5)
        # The learned motion is that of m l^2 q''= -m g l e3 on the sphere: H differs by a constant.
        energies = [learned.energy(each) for each in z]
        self.assertLess(np.ptp(energies), 1e-6)
        self.assertEqual(learned.field(z[0]).shape, (6,))

    def test_written_and_read(self) -> None:
        data = lagroid.trajectories(count=30)
        learned = lagroid.learn(data, "polynomial:1", starts=1, iterations=5)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "model.json"
            learned.write(file)
            again = lagroid.LearnedHamiltonian.read(file)
            np.testing.assert_array_equal(again.parameters, learned.parameters)
            on = lagroid.learn(data, begin=again, iterations=5)
            self.assertLessEqual(on.mse, learned.mse * (1 + 1e-9))
            with self.assertRaises(lagroid.DataError):
                lagroid.LearnedHamiltonian.read(Path(folder) / "none.json")

    def test_states_make_the_same_data(self) -> None:
        data = lagroid.trajectories(chain=2, masses=[1.0, 2.0], count=5)
        again = lagroid.Trajectories(data.states, data.interval * np.arange(data.points))
        np.testing.assert_allclose(again.states, data.states, atol=1e-15)

    def test_mistakes(self) -> None:
        data = lagroid.trajectories(count=4)
        with self.assertRaisesRegex(ValueError, "integrator"):
            lagroid.learn(data, integrator="euler-2")
        with self.assertRaises(lagroid.DataError):
            lagroid.learn(data, "polynom:1")
        with self.assertRaisesRegex(lagroid.SolveError, "data") as caught:
            lagroid.learn(lagroid.trajectories(count=1, points=2), "network:20")
        self.assertEqual(caught.exception.status, "too_little_data")
        with self.assertRaises(ValueError):
            lagroid.Trajectories(2 * data.states, data.interval * np.arange(data.points))
        with self.assertRaisesRegex(ValueError, "states: expected"):
            lagroid.Trajectories(np.zeros((2, 2, 0)), [0, 1])
        with self.assertRaises(lagroid.DataError):
            lagroid.Trajectories.read("missing.csv")


if __name__ == "__main__":
    unittest.main()
