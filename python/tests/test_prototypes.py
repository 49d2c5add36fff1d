"""Discrete Lagrangians written in Python trajectory as those that are compiled."""

import pickle
import unittest
from typing import Any

import lagroid
import numpy as np


class Pendulum(lagroid.System):
    groupoid = lagroid.Pair(1)
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


class Body(lagroid.System):
    groupoid = lagroid.SO3()
    h = 0.05
    inertia = np.array([1.0, 2.0, 3.0])

    def lagrangian(self, g: Any) -> Any:
        w = 2 / (1 + np.trace(g)) * np.array([g[2, 1] - g[1, 2], g[0, 2] - g[2, 0], g[1, 0] - g[0, 1]])
        return (w * self.inertia) @ w / (2 * self.h)


class Bob(lagroid.System):
    groupoid = lagroid.Pair(3)
    h = 0.05

    def lagrangian(self, q0: Any, q1: Any) -> Any:
        return (q1 - q0) @ (q1 - q0) / (2 * self.h) - self.h * (q0[2] + q1[2]) / 2

    def object_constraint(self, q: Any) -> Any:
        return np.array([(q @ q - 1) / 2])


class Steering(lagroid.System):
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


class Damped(Pendulum):
    """With the torque -damping q' in its joint."""

    damping = 0.3

    def forces(self, q0: Any, q1: Any) -> Any:
        half = -self.damping * (q1 - q0) / 2
        return half, half


class Driven(lagroid.System):
    """x'' = cos t, for every step size and start."""

    groupoid = lagroid.Pair(1)
    h = 0.1

    def lagrangian(self, x0: Any, x1: Any, start: float, step: float) -> Any:
        return (x1 - x0) @ (x1 - x0) / (2 * step) + step * np.cos(start + step / 2) * (x0 + x1)[0] / 2


class Blade(lagroid.System):
    """A knife edge on a slope, (x, y, heading): it slides along its edge, unit mass and inertia."""

    groupoid = lagroid.Pair(3)
    h = 0.05
    pull = 1.0
    principle = "nonholonomic"

    def lagrangian(self, q0: Any, q1: Any) -> Any:
        return (q1 - q0) @ (q1 - q0) / (2 * self.h) + self.h * self.pull * (q0[0] + q1[0]) / 2

    def constraint(self, q0: Any, q1: Any) -> Any:
        x, y, _ = q1 - q0
        heading = (q0[2] + q1[2]) / 2
        return x * np.sin(heading) - y * np.cos(heading)

    def started(self) -> Any:
        """Turning at the rate 1, at rest otherwise."""
        return self.integrator(momentum=[0, 0, 1.0], object=[0, 0, 0])

    @staticmethod
    def exact(t: Any) -> tuple[Any, Any]:
        """Position and momentum of the d'Alembert motion: speed sin t along the edge, whose heading is t."""
        q = np.stack([np.sin(t) ** 2 / 2, (t - np.sin(2 * t) / 2) / 2, t], axis=1)
        return q, np.stack([np.sin(t) * np.cos(t), np.sin(t) ** 2, np.ones_like(t)], axis=1)


class Sleigh(lagroid.System):
    """Chaplygin's, on SE(2), by Cayley's map."""

    groupoid = lagroid.SE2()
    h = 0.05
    offset = 0.5
    principle = "nonholonomic"

    def velocity(self, g: Any) -> Any:
        x = 2 * np.linalg.solve(g + np.eye(3), g - np.eye(3)) / self.h
        return np.array([x[1, 0], x[0, 2], x[1, 2]])

    def lagrangian(self, g: Any) -> Any:
        w, ahead, left = self.velocity(g)
        return self.h * (ahead**2 + (left + self.offset * w) ** 2 + w**2) / 2

    def constraint(self, g: Any) -> Any:
        return self.h * self.velocity(g)[2:]


class Prototypes(unittest.TestCase):
    def test_pendulum(self) -> None:
        mine = lagroid.require(lagroid.Pendulum(h=0.1).integrator(momentum=[1.0], object=[0.5]).integrate(200))
        found = Pendulum().integrator(momentum=[1.0], object=[0.5]).integrate(200)
        self.assertEqual(found.status, "converged", found.message)
        np.testing.assert_allclose(found.object, mine.object, atol=1e-12)
        np.testing.assert_allclose(found.momentum, mine.momentum, atol=1e-12)
        np.testing.assert_allclose(found.time, mine.time)

    def test_differences_where_complex_numbers_do_not_serve(self) -> None:
        mine = lagroid.Pendulum(h=0.1).integrator(momentum=[1.0], object=[0.5]).integrate(200)
        for kind in (RealPendulum, SilentPendulum):
            found = kind().integrator(momentum=[1.0], object=[0.5]).integrate(200)
            self.assertEqual(found.status, "converged", found.message)
            error = np.abs(found.object - mine.object).max()
            self.assertLess(error, 1e-9, kind.__name__)

    def test_rigid_body(self) -> None:
        body = lagroid.RigidBody(h=0.05, inertia=[1, 2, 3], rotation="cayley")
        mine = body.integrator(momentum=[1, 0.1, 2]).integrate(60)
        found = Body().integrator(momentum=[1, 0.1, 2]).integrate(60)
        self.assertEqual(found.status, "converged", found.message)
        np.testing.assert_allclose(found.momentum, mine.momentum, atol=1e-12)
        np.testing.assert_allclose(found.configuration[0], mine.configuration, atol=1e-11)

    def test_object_constraint(self) -> None:
        mine = lagroid.SphericalPendulum(h=0.05).integrator(momentum=[0, 0.5, 0], object=[1, 0, 0]).integrate(60)
        found = Bob().integrator(momentum=[0, 0.5, 0], object=[1, 0, 0]).integrate(60)
        self.assertEqual(found.status, "converged", found.message)
        np.testing.assert_allclose(found.object, mine.object, atol=1e-11)
        np.testing.assert_allclose(found.multipliers, mine.multipliers, atol=1e-11)
        np.testing.assert_allclose(found.momentum, mine.momentum, atol=1e-10)
        with self.assertRaisesRegex(ValueError, "^object: off the constraint"):
            Bob().integrator(momentum=[0, 0.5, 0], object=[2, 0, 0])

    def test_a_knife_edge_moves_nonholonomically(self) -> None:
        """Against the closed form, of order two in all that is reported; the vakonomic path is another."""
        errors = []
        for h in (0.1, 0.05):
            found = lagroid.require(Blade(h=h).started().integrate(round(4 / h)))
            q, p = Blade.exact(found.time)
            errors.append([np.abs(found.object - q).max(), np.abs(found.momentum - p).max()])
        order = np.log2(np.array(errors[0]) / errors[1])
        np.testing.assert_allclose(order, 2, atol=0.05)
        vakonomic = lagroid.require(Blade(h=0.05, principle="vakonomic").started().integrate(80))
        self.assertGreater(np.abs(vakonomic.object - q).max(), 1)

    def test_nonholonomic_constraints_are_those_of_compiled_systems(self) -> None:
        run = lagroid.run(
            {
                "system": "chaplygin_sleigh",
                "parameters": {"offset": 0.5, "map": "cayley"},
                "initial": {"position": [0, 0, 0], "velocity": [0.3, -1.0]},
                "time": {"step": 0.05, "steps": 60},
            }
        )
        class Written(Sleigh):
            def annihilator(self, q: Any) -> Any:
                return np.array([[0.0], [0.0], [1.0]])

        for kind in (Sleigh, Written):
            found = kind().integrator(momentum=[1.25 * 0.3, -1.0, 0.5 * 0.3]).integrate(60)
            self.assertEqual(found.status, "converged", found.message)
            np.testing.assert_allclose(found.momentum, run["momentum"], atol=1e-9)
            np.testing.assert_allclose(found.configuration[0][:, 0, 2], run["x"], atol=1e-10)
            np.testing.assert_allclose(found.multipliers[:, 0], run["lambda"], atol=1e-9)

    def test_forces(self) -> None:
        run = lagroid.run(
            {
                "system": "damped_pendulum",
                "parameters": {"damping": 0.3},
                "initial": {"position": [0.5], "momentum": [1.0]},
                "time": {"step": 0.1, "steps": 100},
            }
        )
        found = Damped().integrator(momentum=[1.0], object=[0.5]).integrate(100)
        self.assertEqual(found.status, "converged", found.message)
        np.testing.assert_allclose(found.object[:, 0], run["q"], atol=1e-11)
        np.testing.assert_allclose(found.momentum[:, 0], run["p"], atol=1e-11)
        free = Pendulum().integrator(momentum=[1.0], object=[0.5]).integrate(100)
        self.assertGreater(np.abs(free.object - found.object).max(), 0.1)

    def test_the_step_and_the_start_are_arguments(self) -> None:
        errors = []
        for h in (0.1, 0.05):
            found = lagroid.require(Driven(h=h).integrator(momentum=[0.0], object=[0.0]).integrate(round(6 / h)))
            errors.append(np.abs(found.object[:, 0] - (1 - np.cos(found.time))).max())
        self.assertAlmostEqual(np.log2(errors[0] / errors[1]), 2, delta=0.05)

        class OverAStep(Pendulum):
            def lagrangian(self, q0: Any, q1: Any, step: float) -> Any:
                return (q1 - q0) @ (q1 - q0) / (2 * step) + step * np.cos((q0 + q1) / 2)[0]

        mine = Pendulum().integrator(momentum=[1.0], object=[0.5]).integrate(50)
        np.testing.assert_array_equal(
            OverAStep().integrator(momentum=[1.0], object=[0.5]).integrate(50).object, mine.object
        )

    def test_what_would_not_be_read_is_refused(self) -> None:
        def method(self: Any, *_: Any) -> Any:
            return 0

        for name, value, message in (
            ("force", method, "did you mean forces"),
            ("constraints", method, "did you mean constraint"),
            ("objects_constraint", method, "did you mean object_constraint"),
            ("holonomic_constraint", method, "did you mean constraint"),
            ("external_force", method, "did you mean forces"),
            ("principal", "nonholonomic", "did you mean principle"),
            ("dt", 0.1, "the step is h"),
            ("order", 4, "an option of compiled systems"),
            ("time", 0.0, "start, step"),
            ("quantities", method, "there is no ledger"),
        ):
            with self.assertRaisesRegex(TypeError, f"^Odd: {name} is not read: .*{message}.*_{name}\\)$"):
                type("Odd", (Blade,), {name: value})().started()
            type("Even", (Blade,), {f"_{name}": value})().started()
        odd = Blade()
        odd.force = lambda *_: 0  # type: ignore[attr-defined]
        with self.assertRaisesRegex(TypeError, "force is not read"):
            odd.started()
        for name in ("velocity", "inertia", "energy", "H", "potential"):
            type("Own", (Blade,), {name: method})().started()

        for members, error, message in (
            ({"principle": "nonholonomc"}, ValueError, "principle: 'nonholonomc' is none of vakonomic, nonholonomic"),
            ({"principle": "vakonomic", "annihilator": method}, ValueError, "annihilator: is of nonholonomic"),
            ({"annihilator": lambda self, q: np.ones(3)}, ValueError, r"annihilator: expected an array \(3, 1\)"),
            ({"constraint": lambda self, a, b: np.zeros(0)}, ValueError, "principle: nonholonomic, but there is no"),
            ({"constraint": lambda self, a, b: None}, ValueError, "constraint: expected an array .* got None"),
            ({"constraint": None}, TypeError, "constraint: expected a method"),
            ({"forces": lambda self, a, b: None}, ValueError, "forces: expected two arrays"),
            ({"forces": lambda self, a, b: (0, 0)}, ValueError, r"forces: expected an array \(3,\)"),
            ({"lagrangian": lambda self, a: 0}, TypeError, r"lagrangian: takes \(a\), but an arrow has 2 parts"),
            ({"lagrangian": lambda self, a, b, c, d, e: 0}, TypeError, "after which may come step, or start and step"),
        ):
            with self.assertRaisesRegex(error, message):
                type("Odd", (Blade,), members)().started().advance()
        with self.assertRaisesRegex(NotImplementedError, "no boundary values"):
            Blade().boundary([0, 0, 0, 1, 1, 0], 10)

    def test_parameters_set_later_are_those_of_later_trajectories(self) -> None:
        system = Pendulum()
        integrator = system.integrator(momentum=[1.0], object=[0.5])
        system.h = 0.2
        mine = Pendulum(h=0.1).integrator(momentum=[1.0], object=[0.5]).integrate(10)
        np.testing.assert_array_equal(integrator.integrate(10).object, mine.object)

    def test_integrators_are_pickled(self) -> None:
        integrator = Blade().started()
        integrator.integrate(10)
        again = pickle.loads(pickle.dumps(integrator))
        rest, same = integrator.integrate(10), again.integrate(10)
        for name in ("time", "object", "momentum", "multipliers"):
            np.testing.assert_array_equal(getattr(rest, name), getattr(same, name))

    def test_arrow_constraint(self) -> None:
        run = lagroid.run(
            {
                "system": "attitude_control",
                "parameters": {"rotation": "cayley"},
                "initial": {"momentum": [0.7, -0.3, 0.4]},
                "time": {"step": 0.05, "steps": 60},
            }
        )
        found = Steering().integrator(momentum=[0.7, -0.3, 0.4]).integrate(60)
        self.assertEqual(found.status, "converged", found.message)
        np.testing.assert_allclose(found.momentum, run["momentum"], atol=1e-11)
        np.testing.assert_allclose(found.multipliers[:, 0], run["multipliers"].reshape(-1), atol=1e-11)

    def test_order_two(self) -> None:
        def end(h: float) -> float:
            return float(Pendulum(h=h).integrator(momentum=[1.0], object=[0.5]).integrate(round(2 / h)).object[-1, 0])

        exact = lagroid.Pendulum(h=0.01).integrator(momentum=[1.0], object=[0.5], order=8).integrate(200).object[-1, 0]
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
            Broken().integrator(momentum=[1.0], object=[0.5]).advance()
        self.assertEqual(caught.exception.status, "not_finite")
        with self.assertRaises(lagroid.SolveError) as caught:
            Idle().integrator(momentum=[1.0], object=[0.5]).advance()
        self.assertEqual(caught.exception.status, "singular")
        trajectory = Idle().integrator(momentum=[1.0], object=[0.5]).integrate(5)
        self.assertEqual((trajectory.status, trajectory.steps), ("singular", 0))
        with self.assertRaisesRegex(TypeError, "no parameter length"):
            Pendulum(length=1)
        with self.assertRaisesRegex(ValueError, "momentum: expected 1 numbers"):
            Pendulum().integrator(momentum=[1.0, 2.0], object=[0.5])
        for momentum, q, message in (
            ([1.0], None, "give object"),
            ([1.0], [0.5, 0.5], "object: expected 1 numbers, got 2"),
            ([np.nan], [0.5], "momentum: must be finite"),
            ([1.0], [np.inf], "object: must be finite"),
        ):
            with self.assertRaisesRegex(ValueError, message):
                Pendulum().integrator(momentum=momentum, object=q)
        with self.assertRaisesRegex(TypeError, "takes 1 positional argument"):
            Pendulum().integrator([1.0], [0.5])  # type: ignore[misc]
        with self.assertRaisesRegex(ValueError, "not both"):
            Pendulum().integrator(momentum=[1.0], object=[0.5], configuration=([0.0], [0.5]))
        with self.assertRaisesRegex(ValueError, "tuple of two arrays"):
            Pendulum().integrator(momentum=[1.0], configuration=[0.0, 0.5])
        with self.assertRaisesRegex(ValueError, "has no inverse"):
            Body().integrator(momentum=[1.0, 0.0, 0.0], configuration=np.zeros((3, 3)))
        with self.assertRaisesRegex(ValueError, "expected a matrix"):
            Body().integrator(momentum=[1.0, 0.0, 0.0], configuration=np.eye(4))
        with self.assertRaisesRegex(ValueError, "a group has none"):
            Body().integrator(momentum=[1.0, 0.0, 0.0], object=[0.0])
        with self.assertRaisesRegex(ValueError, "h: the step"):
            Pendulum(h=0.0).integrator(momentum=[1.0], object=[0.5])
        for steps, every in ((-1, 1), (1, 0)):
            with self.assertRaises(ValueError):
                Pendulum().integrator(momentum=[1.0], object=[0.5]).integrate(steps, every)
        with self.assertRaises(NotImplementedError):
            lagroid.System.lagrangian(Pendulum(), 0)

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
                Mistaken().integrator(momentum=[1.0], object=[0.5]).advance()


if __name__ == "__main__":
    unittest.main()
