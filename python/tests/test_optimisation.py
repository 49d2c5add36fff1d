"""Minimising functions of scenes and functions written in Python."""

import json
import unittest
from typing import Any

import lagroid
import numpy as np
from data import EXAMPLES

A = np.diag(np.arange(1.0, 9.0))


def brockett(x: Any) -> tuple[float, Any]:
    return float(np.trace(x.T @ A @ x)), 2 * A @ x


class Optimisation(unittest.TestCase):
    def test_lowest_eigenvectors(self) -> None:
        for method in ("trust-region", "conjugate-gradients", "gradient-descent"):
            found = lagroid.minimise(lagroid.Stiefel(8, 3), brockett, method=method, iterations=100000)
            self.assertTrue(found.converged, f"{method}: {found.message}")
            self.assertAlmostEqual(found.value, 6.0, places=9)
            self.assertEqual(found.x.shape, (8, 3))
            np.testing.assert_allclose(found.x.T @ found.x, np.eye(3), atol=1e-13)
            self.assertEqual(len(found.values), found.iterations + 1)
            self.assertTrue(np.all(np.diff(found.values) < 1e-12))

    def test_hessian(self) -> None:
        asked = 0

        def hessian(x: Any, v: Any) -> Any:
            nonlocal asked
            asked += 1
            self.assertEqual((x.shape, v.shape), ((8, 3), (8, 3)))
            return 2 * A @ v

        found = lagroid.minimise(lagroid.Stiefel(8, 3), brockett, hessian=hessian)
        self.assertTrue(found.converged)
        self.assertGreater(asked, 0)
        self.assertEqual(asked, found.evaluations[2])

    def test_keys_of_a_method(self) -> None:
        found = lagroid.minimise(
            lagroid.Stiefel(8, 2), brockett, method={"name": "gradient-descent", "retraction": "polar"}
        )
        self.assertTrue(found.converged, found.message)
        with self.assertRaisesRegex(lagroid.SceneError, "did you mean"):
            lagroid.minimise(lagroid.Sphere(3), brockett, method="trust-regio")
        with self.assertRaisesRegex(lagroid.SceneError, "unknown key"):
            lagroid.minimise(lagroid.Sphere(3), brockett, method={"name": "robust", "speed": 3})

    def test_arguments_may_be_kept(self) -> None:
        kept: list[Any] = []

        def fun(x: Any) -> tuple[float, Any]:
            kept.append(x)
            return brockett(x.reshape(8, 1))[0], 2 * A @ x

        lagroid.minimise(lagroid.Sphere(8), fun)
        self.assertGreater(len({float(x[0]) for x in kept}), 2)
        for x in kept:
            self.assertAlmostEqual(float(np.linalg.norm(x)), 1.0, places=6)  # Hessians look beside it

    def test_product(self) -> None:
        """Thomson's problem for two: opposite points."""
        manifold = lagroid.ProductManifold([lagroid.Sphere(3), lagroid.Sphere(3)])
        self.assertEqual((manifold.size, manifold.dimension), (6, 4))

        def energy(x: Any) -> tuple[float, Any]:
            apart = x[:3] - x[3:]
            distance = np.linalg.norm(apart)
            return float(1 / distance), np.concatenate([-apart, apart]) / distance**3

        found = lagroid.minimise(manifold, energy, seed=3)
        self.assertAlmostEqual(found.value, 0.5, places=9)

    def test_mean_of_matrices(self) -> None:
        """Of matrices that commute it is the exponential of the mean logarithm."""
        manifold = lagroid.PositiveDefinite(2)
        points = [np.diag([1.0, 4.0]), np.diag([16.0, 4.0])]
        mean = lagroid.FrechetMean(manifold, points)
        found = lagroid.minimise(manifold, mean)
        self.assertTrue(found.converged, found.message)
        np.testing.assert_allclose(found.x, np.diag([4.0, 4.0]), atol=1e-7)
        weighted = lagroid.minimise(manifold, lagroid.FrechetMean(manifold, points, [3, 1]))
        np.testing.assert_allclose(weighted.x, np.diag([2.0, 4.0]), atol=1e-7)
        # Called from Python it is the same function, and one point is the mean of itself.
        slow = lagroid.minimise(manifold, lambda x: mean(x), points[0])
        self.assertAlmostEqual(slow.value, found.value, places=9)
        alone = lagroid.minimise(manifold, lagroid.FrechetMean(manifold, points[:1]))
        self.assertEqual((alone.status, alone.iterations), ("converged", 0))
        with self.assertRaisesRegex(ValueError, "point 1 is not on the"):
            lagroid.FrechetMean(manifold, [np.diag([1.0, -1.0])])
        with self.assertRaisesRegex(ValueError, r"points: expected shape \(2, 2\), got \(2,\)"):
            lagroid.FrechetMean(manifold, [[1.0, 2.0]])
        with self.assertRaisesRegex(ValueError, "hessian: a FrechetMean has its own"):
            lagroid.minimise(manifold, mean, hessian=lambda x, v: v)

    def test_mean_in_hyperbolic_space(self) -> None:
        manifold = lagroid.HyperbolicSpace(2)
        self.assertEqual((manifold.size, manifold.dimension), (3, 2))
        points = [[np.cosh(1), np.sinh(1), 0], [np.cosh(1), -np.sinh(1), 0]]
        found = lagroid.minimise(manifold, lagroid.FrechetMean(manifold, points))
        np.testing.assert_allclose(found.x, [1, 0, 0], atol=1e-7)
        self.assertAlmostEqual(found.value, 0.5, places=12)

    def test_what_python_raises_is_raised(self) -> None:
        with self.assertRaises(ZeroDivisionError):
            lagroid.minimise(lagroid.Sphere(3), lambda x: (1 / 0, x))
        with self.assertRaisesRegex(TypeError, "tuple"):
            lagroid.minimise(lagroid.Sphere(3), lambda x: 1.0)  # type: ignore[arg-type, return-value]
        with self.assertRaisesRegex(ValueError, r"gradient: expected shape \(3,\), got \(2,\)"):
            lagroid.minimise(lagroid.Sphere(3), lambda x: (1.0, [1.0, 2.0]))
        with self.assertRaisesRegex(ValueError, r"start: expected shape \(3,\)"):
            lagroid.minimise(lagroid.Sphere(3), lambda x: (1.0, x), [1.0])
        with self.assertRaises(ValueError):
            lagroid.Stiefel(2, 3)

    def test_shapes_and_kinds(self) -> None:
        manifold = lagroid.Stiefel(8, 3)
        for wrong in (lambda x: brockett(x)[1].T, lambda x: brockett(x)[1].ravel()):
            with self.assertRaisesRegex(ValueError, r"gradient: expected shape \(8, 3\), got"):
                lagroid.minimise(manifold, lambda x, wrong=wrong: (brockett(x)[0], wrong(x)))
        with self.assertRaisesRegex(ValueError, r"start: expected shape \(8, 3\), got \(3, 8\)"):
            lagroid.minimise(manifold, brockett, np.eye(8)[:3])
        with self.assertRaisesRegex(ValueError, r"hessian: expected shape \(8, 3\), got \(3, 8\)"):
            lagroid.minimise(manifold, brockett, hessian=lambda x, v: v.T)
        with self.assertRaisesRegex(TypeError, "^value: expected a number, got str$"):
            lagroid.minimise(manifold, lambda x: ("low", x))  # type: ignore[arg-type, return-value]
        with self.assertRaisesRegex(TypeError, "^gradient: expected numbers, got str$"):
            lagroid.minimise(manifold, lambda x: (1.0, "down"))

    def test_numbers_are_held_to_the_rules_of_scenes(self) -> None:
        for wrong, message in (
            ({"iterations": -1}, "iterations: must be at least 1, got -1"),
            ({"gradient": np.nan}, "gradient: must be finite, got nan"),
            ({"gradient": -1}, "gradient: must be zero or positive, got -1"),
            ({"relative_gradient": 1}, "relative_gradient: must be from 0 to below 1, got 1"),
            ({"seconds": 0}, "seconds: must be positive, got 0"),
            ({"seconds": np.nan}, "seconds: must be positive, got nan"),
        ):
            with self.assertRaisesRegex(ValueError, f"^{message}$"):
                lagroid.minimise(lagroid.Sphere(8), lambda x: (float(x[0]), np.eye(8)[0]), **wrong)  # type: ignore[arg-type]

    def test_a_wrong_gradient_is_not_a_minimum(self) -> None:
        found = lagroid.minimise(lagroid.Sphere(8), lambda x: (float(x @ A @ x), -2 * A @ x), iterations=200)
        self.assertFalse(found.converged and found.value < 1.01)

    def test_scene(self) -> None:
        found = lagroid.optimize(EXAMPLES / "optimisation" / "membrane.toml")
        self.assertTrue(found.converged, found.message)
        self.assertEqual(json.loads(found.summary)["value"], found.value)
        self.assertGreater(len(found.values), 10)
        with self.assertRaises(lagroid.SceneError):
            lagroid.optimize(EXAMPLES / "kepler.toml")


class Control(unittest.TestCase):
    def test_the_shortest_way(self) -> None:
        """Three arcs of a car that cannot turn sharply, from arrays alone."""
        way = lagroid.control(EXAMPLES / "control/shortest_way.toml", set={"horizon.stages": 60})
        self.assertTrue(way.converged, way.message)
        self.assertEqual((way.states.shape, way.controls.shape, way.times.shape), ((61, 3), (60, 1), (61,)))
        self.assertEqual(way.costates.shape, (60, len(way.costate_names)))
        self.assertEqual((way.costate_names, way.costate_units), (["M", "p1", "p2"], ["s/rad", "s/m", "s/m"]))
        self.assertEqual((way.state_units, way.control_units), (["m", "m", "rad"], ["1/m"]))
        self.assertAlmostEqual(way.cost, way.duration, places=12)
        self.assertAlmostEqual(way.cost, float(way.times[-1]), places=12)
        self.assertEqual(way.costs[0], way.cost)
        steps = np.diff(way.states[:, way.state_names.index("x")]), np.diff(way.states[:, way.state_names.index("y")])
        self.assertTrue(np.all(np.hypot(*steps) <= np.diff(way.times) * (1 + 1e-9)))
        self.assertEqual(json.loads(way.summary)["cost"], way.cost)

    def test_phases(self) -> None:
        """Through a gate and on to a circle, each in its own time."""
        way = lagroid.control(EXAMPLES / "control/through_a_gate.toml", set={"solver.starts": 2})
        self.assertTrue(way.converged, way.message)
        self.assertEqual(list(way.phases), ["to the gate", "to the circle"])
        self.assertAlmostEqual(sum(way.phases.values()), way.duration, places=12)
        x, y, angle = way.states[60]
        self.assertAlmostEqual(x, 2, places=9)
        self.assertAlmostEqual(angle, 0, places=9)
        self.assertAlmostEqual(np.hypot(way.states[-1][0] - 6, way.states[-1][1] - 3), 1, places=9)
        self.assertEqual(lagroid.control(EXAMPLES / "control/shortest_way.toml", set={"solver.starts": 1}).phases, {})

    def test_one_side(self) -> None:
        """A bound on one side alone: the stop of a mass that can only be pushed back so hard."""
        bounds = {"bounds.u": {"min": -1.0}, "parameters.cost": "effort", "horizon.free": False, "horizon.duration": 3.0}
        found = lagroid.control(EXAMPLES / "control/fastest_stop.toml", set={**bounds, "horizon.stages": 40})
        self.assertTrue(found.converged, found.message)
        self.assertGreaterEqual(found.controls.min(), -1 - 1e-9)

    def test_no_way(self) -> None:
        """A mass that cannot stop in time."""
        late = lagroid.control(
            EXAMPLES / "control/fastest_stop.toml",
            set={"horizon.free": False, "horizon.duration": 0.5, "horizon.stages": 20, "solver.starts": 2},
        )
        self.assertFalse(late.converged)
        self.assertEqual(late.status, "infeasible")

    def test_what_is_mistaken(self) -> None:
        with self.assertRaisesRegex(lagroid.SceneError, "below"):
            lagroid.control(EXAMPLES / "control/fastest_stop.toml", set={"bounds.u": [1, -1]})
        with self.assertRaisesRegex(lagroid.SceneError, "run"):
            lagroid.control(EXAMPLES / "kepler.toml")

    def test_a_loop_is_closed_by_a_motion_of_ones_own(self) -> None:
        loop = lagroid.control_loop(EXAMPLES / "control/control_loop.toml", set={"horizon.stages": 20})
        self.assertEqual((loop.status, len(loop.state_names), len(loop.control_names)), ("converged", 6, 3))
        push = np.zeros(6)
        for sample in range(30):
            push[3] = 0.01 if sample == 5 else 0
            control = loop.advance(loop.predicted + push)
            self.assertEqual(loop.status, "converged")
            self.assertLessEqual(loop.iterations, 20)
            self.assertLessEqual(np.abs(control).max(), 0.6 + 1e-9)
        self.assertLess(np.abs(loop.predicted - [0.39036, 1.9518001, 0.19518, 0, 0, 0]).max(), 0.1)
        self.assertEqual(loop.step, 0.5)
        self.assertGreaterEqual(loop.latency(99), loop.latency(50))
        with self.assertRaisesRegex(ValueError, "6 numbers"):
            loop.advance([0, 1])
        with self.assertRaisesRegex(ValueError, "finite"):
            loop.advance([np.nan] * 6)
        with self.assertRaisesRegex(lagroid.SceneError, "free"):
            lagroid.control_loop(EXAMPLES / "control/fastest_stop.toml")
        with self.assertRaisesRegex(lagroid.SceneError, "M1 is conserved"):
            lagroid.control_loop(EXAMPLES / "control/falling_cat.toml", set={"solver.starts": 1})


if __name__ == "__main__":
    unittest.main()
