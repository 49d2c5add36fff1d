"""Pictures are drawn without a window, and hold the run's numbers."""

import io
import os
import unittest

import lagroid
import numpy as np
from data import EXAMPLES


class Plots(unittest.TestCase):
    def setUp(self) -> None:
        os.environ.pop("DISPLAY", None)
        self.run_ = lagroid.run(EXAMPLES / "kepler.toml", set={"time.steps": 200})

    def test_trajectory(self) -> None:
        figure = lagroid.plot.trajectory(self.run_)
        self.assertEqual(len(figure.axes), len(self.run_.panels))
        line = figure.axes[0].lines[0]
        np.testing.assert_array_equal(line.get_xdata(), self.run_["x"])
        np.testing.assert_array_equal(line.get_ydata(), self.run_["y"])
        picture = io.BytesIO()
        figure.savefig(picture, format="png", dpi=40)
        self.assertGreater(len(picture.getvalue()), 2000)

    def test_columns(self) -> None:
        ball = lagroid.run(EXAMPLES / "plate_ball_initial_value.toml", set={"time.steps": 20})
        figure = lagroid.plot.trajectory(ball, ["x", "lambda1"])
        self.assertEqual([len(line.get_xdata()) for line in figure.axes[0].lines], [21, 20])
        with self.assertRaises(ValueError):
            lagroid.plot.trajectory(lagroid.run(EXAMPLES / "kepler.toml", record=False))

    def test_trajectories(self) -> None:
        trajectory = lagroid.SphericalPendulum(h=0.02).integrator(momentum=[0.1, 0.5, 0], object=[1, 0, 0]).integrate(20)
        figure = lagroid.plot.trajectory(trajectory)
        self.assertEqual([axes.get_ylabel() for axes in figure.axes], ["object", "momentum", *trajectory.quantities])
        np.testing.assert_array_equal(figure.axes[0].lines[2].get_ydata(), trajectory.object[:, 2])
        figure = lagroid.plot.trajectory(trajectory, ["multipliers"])
        self.assertEqual(len(figure.axes[0].lines[0].get_xdata()), 20)
        body = lagroid.RigidBody(h=0.1).integrator(momentum=[1, 2, 3]).integrate(5)
        self.assertNotIn("object", [axes.get_ylabel() for axes in lagroid.plot.trajectory(body).axes])

        class Free(lagroid.System):
            groupoid = lagroid.Pair(2)

            def lagrangian(self, q0, q1):  # type: ignore[no-untyped-def]
                return (q1 - q0) @ (q1 - q0) / (2 * self.h)

        prototype = Free().integrator(momentum=[1, 0], object=[0, 0]).integrate(5)
        self.assertEqual([len(axes.lines) for axes in lagroid.plot.trajectory(prototype).axes], [2, 2])
        with self.assertRaisesRegex(ValueError, "^trajectory: energi is none of object, momentum"):
            lagroid.plot.trajectory(trajectory, ["energi"])
        with self.assertRaisesRegex(TypeError, "^trajectory: draws a RunResult, Trajectory or PrototypeTrajectory, not Kepler$"):
            lagroid.plot.trajectory(lagroid.Kepler())  # type: ignore[arg-type]

    def test_ledger(self) -> None:
        figure = lagroid.plot.ledger(self.run_)
        self.assertEqual(len(figure.axes[0].patches), len(self.run_.ledger))
        integrator = lagroid.Kepler(h=0.01).integrator(momentum=[0, 1], object=[1, 0])
        integrator.integrate(10)
        for entries in (integrator, integrator.ledger):
            self.assertEqual(len(lagroid.plot.ledger(entries).axes[0].patches), 2)

    def test_study(self) -> None:
        found = lagroid.study(
            EXAMPLES / "pendulum.toml",
            set={"time.steps": 50},
            methods=["splitting", "runge-kutta"],
            steps=[0.1, 0.05],
            reference_time=0.5,
            repetitions=1,
        )
        figure = lagroid.plot.study(found)
        self.assertEqual({line.get_label() for line in figure.axes[0].lines}, {"splitting", "runge-kutta"})
        styles = {(line.get_color(), line.get_marker()) for line in figure.axes[0].lines}
        self.assertEqual(len(styles), 2)


if __name__ == "__main__":
    unittest.main()
