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

    def test_a_damped_oscillator_in_the_plane(self) -> None:
        # q'' + 2 c q' + q = 0 in closed form, H = (p^2 + q^2) / 2 and R = 2 c.
        c = 0.1
        w = np.sqrt(1 - c * c)
        time = 0.1 * np.arange(5)
        start = np.random.default_rng(1).uniform(-1, 1, (30, 2, 1))
        q0, p0 = start[:, 0], start[:, 1]
        decay, cosine, sine = np.exp(-c * time), np.cos(w * time), np.sin(w * time)
        q = decay * (q0 * cosine + (p0 + c * q0) / w * sine)
        p = decay * (p0 * cosine - (q0 + c * p0) / w * sine)
        data = lagroid.Trajectories(np.stack([q, p], axis=-1), time, spheres=False)
        self.assertEqual((data.bodies, data.states.shape), (0, (30, 5, 2)))
        learned = lagroid.learn(data, "polynomial:2", starts=1, substeps=8, dissipation=True)
        np.testing.assert_allclose(learned.dissipation, [[2 * c]], atol=1e-7)
        np.testing.assert_allclose(learned.parameters[:-1], [0, 0, 0.5, 0, 0.5], atol=1e-7)
        np.testing.assert_allclose(learned.rates(np.array([1.0, 2.0])), [2, -1 - 2 * c * 2], atol=1e-6)
        self.assertEqual(learned.mass.size, 0)
        self.assertTrue(learned.dissipation_determined)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "model.json"
            learned.write(file)
            np.testing.assert_array_equal(lagroid.LearnedHamiltonian.read(file).dissipation, learned.dissipation)
        with self.assertRaisesRegex(ValueError, "on R\\^2, the data on"):
            lagroid.learn(lagroid.trajectories(count=4), begin=learned)

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
        with self.assertRaisesRegex(ValueError, "spheres=False"):
            lagroid.Trajectories(np.zeros((2, 2, 4)), [0, 1])
        with self.assertRaisesRegex(ValueError, "declares none"):
            lagroid.learn(data, begin=lagroid.learn(data, "polynomial:1", starts=1, iterations=2), dissipation=True)
        with self.assertRaisesRegex(ValueError, "points"):
            lagroid.Trajectories.read("missing.csv", points=-5)
        with self.assertRaises(lagroid.DataError):
            lagroid.Trajectories.read("missing.csv")


if __name__ == "__main__":
    unittest.main()
