"""Ctrl-C while C++ computes."""

import os
import signal
import threading
import time
import unittest

import lagroid
from data import EXAMPLES


def interrupt(after: float) -> None:
    """Ctrl-C, later."""

    def send() -> None:
        time.sleep(after)
        os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=send).start()


class Interrupts(unittest.TestCase):
    def test_a_run_keeps_what_was_computed(self) -> None:
        interrupt(0.2)
        with self.assertRaises(lagroid.Interrupted) as caught:
            lagroid.run(EXAMPLES / "kepler.toml", set={"time.steps": 2_000_000_000}, record=False)
        self.assertIsInstance(caught.exception, KeyboardInterrupt)
        self.assertGreater(caught.exception.result.steps, 0)
        self.assertEqual(caught.exception.result.status, "interrupted")

    def test_afterwards_all_is_as_before(self) -> None:
        before = signal.getsignal(signal.SIGINT)
        for _ in range(2):
            interrupt(0.1)
            with self.assertRaises(KeyboardInterrupt):
                lagroid.run(EXAMPLES / "kepler.toml", set={"time.steps": 2_000_000_000}, record=False)
            self.assertTrue(lagroid.run(EXAMPLES / "kepler.toml", set={"time.steps": 10}).converged)
        self.assertIs(signal.getsignal(signal.SIGINT), before)
        interrupt(0.1)
        with self.assertRaises(KeyboardInterrupt):
            time.sleep(20)

    def test_a_trajectory_keeps_its_place(self) -> None:
        integrator = lagroid.Pendulum(h=0.01).integrator(momentum=[1], object=[0])
        interrupt(0.2)
        with self.assertRaises(KeyboardInterrupt):
            integrator.integrate(10**9, every=10**9)
        reached = integrator.index
        self.assertGreater(reached, 0)
        integrator.advance()
        self.assertEqual(integrator.index, reached + 1)

    def test_studies_optimisation_and_learning(self) -> None:
        data = lagroid.trajectories(chain=2, count=500)

        def slow(x):  # type: ignore[no-untyped-def]
            time.sleep(0.01)
            return float(x[0] ** 4 + x[1]), [4 * x[0] ** 3, 1, 0]

        for call in (
            lambda: lagroid.learn(data, "network:12", starts=3, iterations=100000),
            lambda: lagroid.minimise(lagroid.Sphere(3), slow, method="robust", relative_gradient=1e-300),
            lambda: lagroid.study(EXAMPLES / "kepler.toml", longest=20),
        ):
            interrupt(0.3)
            start = time.monotonic()
            with self.assertRaises(KeyboardInterrupt):
                call()
            self.assertLess(time.monotonic() - start, 30)


if __name__ == "__main__":
    unittest.main()
