"""Discrete Lagrangians written in Python march as those that are compiled."""

import unittest
from typing import Any

import lagroid
import numpy as np


class Pendulum(lagroid.DiscreteLagrangian):
    groupoid = lagroid.Pairs(1)
    h = 0.1

    def lagrangian(self, q0: Any, q1: Any) -> Any:
        return (q1 - q0) @ (q1 - q0) / (2 * self.h) + self.h * np.cos((q0 + q1) / 2)[0]


class RealPendulum(Pendulum):
    """The same, of real numbers only."""

    def lagrangian(self, q0: Any, q1: Any) -> Any:
        return float(np.linalg.norm(q1 - q0) ** 2 / (2 * self.h) + self.h * np.cos((q0 + q1) / 2)[0])


class SilentPendulum(Pendulum):
    """The same, whose abs spoils complex steps without an error."""

    def lagrangian(self, q0: Any, q1: Any) -> Any:
        return np.abs(q1 - q0)[0] ** 2 / (2 * self.h) + self.h * np.cos((q0 + q1) / 2)[0]


class Body(lagroid.DiscreteLagrangian):
    groupoid = lagroid.SO3()
    h = 0.05
    inertia = np.array([1.0, 2.0, 3.0])

    def lagrangian(self, g: Any) -> Any:
        w = 2 / (1 + np.trace(g)) * np.array([g[2, 1] - g[1, 2], g[0, 2] - g[2, 0], g[1, 0] - g[0, 1]])
        return (w * self.inertia) @ w / (2 * self.h)


class Bob(lagroid.DiscreteLagrangian):
    groupoid = lagroid.Pairs(3)
    h = 0.05

    def lagrangian(self, q0: Any, q1: Any) -> Any:
        return (q1 - q0) @ (q1 - q0) / (2 * self.h) - self.h * (q0[2] + q1[2]) / 2

    def object_constraint(self, q: Any) -> Any:
        return np.array([(q @ q - 1) / 2])


class Steering(lagroid.DiscreteLagrangian):
    """Optimal control of a rotation with one axis forbidden, w3 = 0."""

    groupoid = lagroid.SO3()
    h = 0.05

    def velocity(self, g: Any) -> Any:
        return 2 / (1 + np.trace(g)) * np.array([g[2, 1] - g[1, 2], g[0, 2] - g[2, 0], g[1, 0] - g[0, 1]]) / self.h

    def lagrangian(self, g: Any) -> Any:
        w = self.velocity(g)
        return self.h * (w @ w) / 2

    def constraint(self, g: Any) -> Any:
        return self.h * self.velocity(g)[2:]


class Prototypes(unittest.TestCase):
    def test_pendulum(self) -> None:
        mine = lagroid.require(lagroid.Pendulum(h=0.1).integrator([1.0], [0.5]).march(200))
        found = Pendulum().integrator([1.0], [0.5]).march(200)
        self.assertEqual(found.status, "converged", found.message)
        np.testing.assert_allclose(found.object, mine.object, atol=1e-12)
        np.testing.assert_allclose(found.momentum, mine.momentum, atol=1e-12)
        np.testing.assert_allclose(found.time, mine.time)

    def test_differences_where_complex_numbers_do_not_serve(self) -> None:
        mine = lagroid.Pendulum(h=0.1).integrator([1.0], [0.5]).march(200)
        for kind in (RealPendulum, SilentPendulum):
            found = kind().integrator([1.0], [0.5]).march(200)
            self.assertEqual(found.status, "converged", found.message)
            error = np.abs(found.object - mine.object).max()
            self.assertLess(error, 1e-9, kind.__name__)

    def test_rigid_body(self) -> None:
        body = lagroid.RigidBody(h=0.05, inertia=[1, 2, 3], rotation="cayley")
        mine = body.integrator([1, 0.1, 2]).march(60)
        found = Body().integrator([1, 0.1, 2]).march(60)
        self.assertEqual(found.status, "converged", found.message)
        np.testing.assert_allclose(found.momentum, mine.momentum, atol=1e-12)
        np.testing.assert_allclose(found.configuration[0], mine.configuration, atol=1e-11)

    def test_object_constraint(self) -> None:
        mine = lagroid.SphericalPendulum(h=0.05).integrator([0, 0.5, 0], [1, 0, 0]).march(60)
        found = Bob().integrator([0, 0.5, 0], [1, 0, 0]).march(60)
        self.assertEqual(found.status, "converged", found.message)
        np.testing.assert_allclose(found.object, mine.object, atol=1e-11)
        np.testing.assert_allclose(found.multipliers, mine.multipliers, atol=1e-11)

    def test_arrow_constraint(self) -> None:
        run = lagroid.run(
            {
                "system": "attitude_control",
                "parameters": {"rotation": "cayley"},
                "initial": {"momentum": [0.7, -0.3, 0.4]},
                "time": {"step": 0.05, "steps": 60},
            }
        )
        found = Steering().integrator([0.7, -0.3, 0.4]).march(60)
        self.assertEqual(found.status, "converged", found.message)
        np.testing.assert_allclose(found.momentum, run["momentum"], atol=1e-11)
        np.testing.assert_allclose(found.multipliers[:, 0], run["multipliers"].reshape(-1), atol=1e-11)

    def test_order_two(self) -> None:
        def end(h: float) -> float:
            return float(Pendulum(h=h).integrator([1.0], [0.5]).march(round(2 / h)).object[-1, 0])

        exact = lagroid.Pendulum(h=0.01).integrator([1.0], [0.5], order=8).march(200).object[-1, 0]
        order = np.log2((end(0.1) - exact) / (end(0.05) - exact))
        self.assertAlmostEqual(order, 2, delta=0.05)

    def test_groups(self) -> None:
        for group, dimension in ((lagroid.SO3(), 3), (lagroid.SE3(), 6), (lagroid.SE2(), 3)):
            self.assertEqual(group.dimension, dimension)
            v = 0.3 * np.arange(1, dimension + 1)
            np.testing.assert_allclose(group.exp(v) @ group.exp(-v), np.eye(len(group.basis[0])), atol=1e-14)
            np.testing.assert_allclose(group.exp(2 * v), group.exp(v) @ group.exp(v), atol=1e-14)

    def test_mistakes_are_typed(self) -> None:
        class Broken(Pendulum):
            def lagrangian(self, q0: Any, q1: Any) -> Any:
                return np.nan * (q0 @ q1)

        class Idle(Pendulum):
            def lagrangian(self, q0: Any, q1: Any) -> Any:
                return (q0 + 0 * q1).sum()

        with self.assertRaises(lagroid.SolveError) as caught:
            Broken().integrator([1.0], [0.5]).advance()
        self.assertEqual(caught.exception.status, "not_finite")
        with self.assertRaises(lagroid.SolveError) as caught:
            Idle().integrator([1.0], [0.5]).advance()
        self.assertEqual(caught.exception.status, "singular")
        march = Idle().integrator([1.0], [0.5]).march(5)
        self.assertEqual((march.status, march.steps), ("singular", 0))
        with self.assertRaisesRegex(TypeError, "no parameter length"):
            Pendulum(length=1)
        with self.assertRaisesRegex(ValueError, "momentum: expected 1 numbers"):
            Pendulum().integrator([1.0, 2.0], [0.5])
        for arguments, message in (
            (([1.0],), "give object"),
            (([1.0], [0.5, 0.5]), "object: expected 1 numbers, got 2"),
            (([np.nan], [0.5]), "momentum: must be finite"),
            (([1.0], [np.inf]), "object: must be finite"),
        ):
            with self.assertRaisesRegex(ValueError, message):
                Pendulum().integrator(*arguments)
        with self.assertRaisesRegex(ValueError, "not both"):
            Pendulum().integrator([1.0], [0.5], configuration=([0.0], [0.5]))
        with self.assertRaisesRegex(ValueError, "tuple of two arrays"):
            Pendulum().integrator([1.0], configuration=[0.0, 0.5])
        with self.assertRaisesRegex(ValueError, "has no inverse"):
            Body().integrator([1.0, 0.0, 0.0], configuration=np.zeros((3, 3)))
        with self.assertRaisesRegex(ValueError, "expected a matrix"):
            Body().integrator([1.0, 0.0, 0.0], configuration=np.eye(4))
        with self.assertRaisesRegex(ValueError, "a group has none"):
            Body().integrator([1.0, 0.0, 0.0], [0.0])
        with self.assertRaisesRegex(ValueError, "h: the step"):
            Pendulum(h=0.0).integrator([1.0], [0.5])
        for steps, every in ((-1, 1), (1, 0)):
            with self.assertRaises(ValueError):
                Pendulum().integrator([1.0], [0.5]).march(steps, every)
        with self.assertRaises(NotImplementedError):
            lagroid.DiscreteLagrangian.lagrangian(Pendulum(), 0)

    def test_a_lagrangian_that_is_no_number(self) -> None:
        for value, message in (
            (None, "expected a number, got None"),
            (np.ones(2), r"expected a number, got an array \(2,\)"),
            ("x", "expected a number, got 'x'"),
        ):

            class Mistaken(Pendulum):
                def lagrangian(self, q0: Any, q1: Any, value: Any = value) -> Any:
                    return value

            with self.assertRaisesRegex(ValueError, message):
                Mistaken().integrator([1.0], [0.5]).advance()


if __name__ == "__main__":
    unittest.main()
