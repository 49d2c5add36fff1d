"""Systems as objects: the same numbers as scenes, step by step and many at once."""

import copy
import pickle
import threading
import unittest

import lagroid
import numpy as np
from data import EXAMPLES


def turned(angle: float) -> np.ndarray:
    """By the angle about the first axis."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])


class Named(lagroid.Pendulum):
    """A system with something besides its parameters."""

    def __init__(self, name: str, **parameters: float) -> None:
        super().__init__(**parameters)
        self.name = name


class Stiff(lagroid.Pendulum):
    """A system with a property of its own."""

    @property
    def softness(self) -> float:
        return 1 / self.gravity

    @softness.setter
    def softness(self, value: float) -> None:
        self.gravity = 1 / value


class Systems(unittest.TestCase):
    def test_a_trajectory_is_the_run_of_the_scene(self) -> None:
        run = lagroid.run(
            {
                "system": "kepler",
                "initial": {"position": [0.4, 0], "momentum": [0, 2]},
                "time": {"step": 0.05, "steps": 500},
            }
        )
        system = lagroid.Kepler(h=0.05, quadrature="trapezoid")
        integrator = system.integrator(momentum=[0, 2], object=[0.4, 0])
        trajectory = integrator.integrate(500)
        np.testing.assert_array_equal(trajectory.object, run["position"])
        np.testing.assert_array_equal(trajectory.momentum, run["momentum"])
        np.testing.assert_array_equal(trajectory.time, run.time)
        for mine, theirs in zip(integrator.ledger, run.ledger):
            self.assertEqual((mine.name, mine.drift, mine.verdict), (theirs.name, theirs.drift, theirs.verdict))

    def test_the_ledger_holds_the_constraints(self) -> None:
        ball = lagroid.PlateBall(h=0.05, plate_rate=0.3)
        integrator = ball.integrator(momentum=[0.5, 0.2, 0.1, 0.2, 0.3], object=[0.1, 0])
        integrator.integrate(200)
        run = lagroid.run(
            {
                "system": "plate_ball",
                "parameters": {"plate_rate": 0.3},
                "initial": {"position": [0.1, 0], "momentum": [0.5, 0.2, 0.1, 0.2, 0.3]},
                "time": {"step": 0.05, "steps": 200},
            }
        )
        told = [(entry.name, entry.drift, entry.bound, entry.verdict) for entry in integrator.ledger]
        self.assertEqual(told[0][0], "constraint residual")
        self.assertEqual(told, [(entry.name, entry.drift, entry.bound, entry.verdict) for entry in run.ledger])
        self.assertEqual(ball.integrator(momentum=[0.5, 0.2, 0.1, 0.2, 0.3], object=[0.1, 0], ledger=False).ledger, [])

    def test_bodies_are_those_of_scenes(self) -> None:
        angle = 0.3
        scene = {
            "system": "heavy_top",
            "parameters": {"inertia": [1.0, 1.2, 0.5], "weight": [0.1, 0.0, 1.0]},
            "initial": {"attitude": [angle, 0.0, 0.0], "momentum": [0.1, 0.2, 1.5]},
            "time": {"step": 0.02, "steps": 200},
        }
        run = lagroid.run(scene)
        top = lagroid.HeavyTop(inertia=[1.0, 1.2, 0.5], weight=[0.1, 0, 1], h=0.02, rotation="exp")
        trajectory = top.integrator(momentum=[0.1, 0.2, 1.5], configuration=top.arrow(turned(angle))).integrate(200)
        np.testing.assert_allclose(trajectory.object, run["position"], atol=1e-13)
        np.testing.assert_allclose(trajectory.momentum, run["momentum"], atol=1e-13)
        self.assertEqual(trajectory.configuration.shape, (201, 12))

    def test_attitudes_are_matrices(self) -> None:
        start = turned(1.0)
        body = lagroid.RigidBody(inertia=[1, 2, 3], h=0.01)
        trajectory = body.integrator(momentum=[1, 0.5, 2], configuration=start).integrate(300)
        np.testing.assert_allclose(trajectory.configuration[0], start, atol=1e-15)
        spatial = np.einsum("kij,kj->ki", trajectory.configuration, trajectory.momentum)
        np.testing.assert_allclose(spatial, np.broadcast_to(spatial[0], spatial.shape), atol=1e-13)
        np.testing.assert_allclose(trajectory.configuration[5] @ trajectory.arrow[5], trajectory.configuration[6], atol=1e-14)

    def test_one_step_at_a_time(self) -> None:
        system = lagroid.SphericalPendulum(h=0.02)
        together = system.integrator(momentum=[0.1, 0.5, 0], object=[1, 0, 0]).integrate(50)
        one = system.integrator(momentum=[0.1, 0.5, 0], object=[1, 0, 0])
        for k in range(1, 51):
            one.advance()
            np.testing.assert_array_equal(one.object, together.object[k])
            np.testing.assert_array_equal(one.state[1], together.momentum[k])
        self.assertEqual(one.index, 50)
        self.assertEqual(one.time, together.time[-1])
        np.testing.assert_array_equal(one.multipliers, together.multipliers[-1])
        self.assertEqual(one.quantity("energy").shape, (1,))

    def test_every_nth_node_and_the_last(self) -> None:
        trajectory = lagroid.Pendulum(h=0.1).integrator(momentum=[1], object=[0]).integrate(25, every=10)
        np.testing.assert_allclose(trajectory.time, [0, 1, 2, 2.5])
        self.assertEqual(trajectory.arrow.shape, (3, 2))
        self.assertEqual(trajectory.quantities["energy"].shape, (4, 1))

    def test_arrays_are_the_trajectorys_own_numbers(self) -> None:
        trajectory = lagroid.Pendulum().integrator(momentum=[1], object=[0]).integrate(10)
        self.assertTrue(np.shares_memory(trajectory.object, trajectory.object))
        self.assertFalse(trajectory.object.flags.writeable)
        kept = trajectory.object
        expected = kept.copy()
        del trajectory
        np.testing.assert_array_equal(kept, expected)

    def test_modes_and_orders(self) -> None:
        system = lagroid.Kepler(h=0.1)
        self.assertIn("order 8", system.integrator(momentum=[0, 1.2], object=[1, 0], order=8).method)
        self.assertIn("explicit", system.integrator(momentum=[0, 1.2], object=[1, 0], method="splitting").method)
        extrapolated = system.integrator(momentum=[0, 1.2], object=[1, 0], method="extrapolation", tolerance=1e-12)
        self.assertIn("extrapolation", extrapolated.method)
        composed = lagroid.Kepler(h=0.01).integrator(momentum=[0, 1.2], object=[1, 0], order=8)
        np.testing.assert_allclose(extrapolated.integrate(20).object[-1], composed.integrate(200).object[-1], atol=1e-10)
        trajectory = system.integrator(momentum=[0, 1.2], object=[1, 0], mode="controlled").integrate(20)
        self.assertGreater(np.ptp(trajectory.step_size), 1e-3)
        wrongs = (
            {"mode": "fast"},
            {"order": 3},
            {"composition": "none"},
            {"order": 4, "composition": "kahan-li-8"},
            {"method": "extrapolation"},
        )
        for wrong in wrongs:
            with self.assertRaises(ValueError):
                system.integrator(momentum=[0, 1.2], object=[1, 0], **wrong)  # type: ignore[arg-type]

    def test_mistakes(self) -> None:
        with self.assertRaisesRegex(TypeError, "Kepler has no parameter mass"):
            lagroid.Kepler(mass=1)
        with self.assertRaisesRegex(ValueError, "momentum: expected 2 numbers, got 1"):
            lagroid.Kepler().integrator(momentum=[1], object=[0, 0])
        with self.assertRaisesRegex(ValueError, "object: must be finite"):
            lagroid.Kepler().integrator(momentum=[1, 0], object=[0, np.nan])
        with self.assertRaisesRegex(ValueError, "give object"):
            lagroid.Kepler().integrator(momentum=[1, 0])
        with self.assertRaisesRegex(ValueError, "off the constraint"):
            lagroid.SphericalPendulum().integrator(momentum=[0, 0, 0], object=[2, 0, 0])
        with self.assertRaisesRegex(ValueError, "no arrow of SO"):
            lagroid.RigidBody().integrator(momentum=[0, 0, 1], configuration=2 * np.eye(3))
        with self.assertRaisesRegex(ValueError, "h: the step"):
            lagroid.Kepler(h=0).integrator(momentum=[1, 0], object=[1, 0])
        for h in (0, np.nan, np.inf):
            with self.assertRaisesRegex(ValueError, "h: the step"):
                lagroid.Kepler(h=h).boundary([1, 0, 0, 1], 10)
        with self.assertRaisesRegex(ValueError, "quadrature"):
            lagroid.Kepler(quadrature="simpson")

    def test_a_start_must_be_given(self) -> None:
        with self.assertRaises(TypeError):
            lagroid.Integrator(None)  # type: ignore[arg-type]

    def test_fields_without_numbers_have_rows(self) -> None:
        body = lagroid.RigidBody(h=0.1).integrator(momentum=[1, 2, 3])
        q, momentum = body.state
        self.assertEqual((q.shape, body.object.shape, momentum.shape), ((0,), (0,), (3,)))
        trajectory = body.integrate(4)
        self.assertEqual((trajectory.object.shape, trajectory.multipliers.shape), ((5, 0), (4, 0)))
        self.assertEqual(body.multipliers.shape, (0,))
        kepler = lagroid.Kepler().integrator(momentum=[0, 1], object=[1, 0])
        self.assertEqual(kepler.integrate(3, every=2).multipliers.shape, (2, 0))
        path = lagroid.RigidBody(h=0.1).boundary(turned(0.5), 5)[0]
        self.assertEqual((path.object.shape, path.multipliers.shape), ((6, 0), (5, 0)))

    def test_what_is_no_arrow_is_refused(self) -> None:
        body = lagroid.RigidBody(h=0.1)
        reflection = np.diag([1.0, 1.0, -1.0])
        wrongs = (np.zeros((3, 3)), -np.eye(3), reflection, turned(0.3) @ reflection, 2 * np.eye(3), np.ones((3, 3)))
        for wrong in wrongs:
            with self.assertRaisesRegex(ValueError, "^configuration: no arrow of SO"):
                body.integrator(momentum=[1, 2, 3], configuration=wrong)
            with self.assertRaisesRegex(ValueError, "^arrow: no arrow of SO"):
                body.boundary(wrong, 10)
            with self.assertRaisesRegex(ValueError, "^configuration: no arrow of SO"):
                top = lagroid.HeavyTop()
                top.integrator(momentum=[1, 2, 3], configuration=top.arrow(wrong))
            with self.assertRaisesRegex(ValueError, "^arrow: no arrow of "):
                lagroid.PlateBall().boundary(lagroid.PlateBall.arrow([0, 0], [1, 0], wrong), 10)
        for shape in ((1, 9), (9, 1), (3, 3, 1)):
            with self.assertRaisesRegex(ValueError, r"configuration: expected 9 numbers or shape \(3, 3\)"):
                body.integrator(momentum=[1, 2, 3], configuration=np.eye(3).reshape(shape))
        with self.assertRaisesRegex(ValueError, "object: no object of"):
            lagroid.HeavyTop().integrator(momentum=[1, 2, 3], object=[0, 0, 2])

    def test_every_arrow_is_taken(self) -> None:
        """Half turns too, which a retraction may miss, and arrows far from the units."""
        rng = np.random.default_rng(1)
        axes = [*np.eye(3), *rng.normal(size=(40, 3))]
        body, top, ball = lagroid.RigidBody(), lagroid.HeavyTop(), lagroid.PlateBall()
        for axis in axes:
            n = axis / np.linalg.norm(axis)
            hat = np.cross(np.eye(3), n)
            for angle in (np.pi, np.pi - 1e-7, np.pi - 1e-4, rng.uniform(0, np.pi)):
                turn = np.eye(3) + np.sin(angle) * hat + (1 - np.cos(angle)) * hat @ hat
                body.integrator(momentum=[1, 2, 3], configuration=turn)
                top.integrator(momentum=[1, 2, 3], configuration=top.arrow(turn))
                ball.integrator(momentum=[1, 2, 3, 4, 5], configuration=ball.arrow([1e6, 0], [0, -1e6], turn))
        self.assertTrue(lagroid.RigidBody(h=0.1).boundary(turned(np.pi), 10))

    def test_parameters_are_held_to_the_rules_of_scenes(self) -> None:
        for make, message in (
            (lambda: lagroid.Kepler(strength=np.nan), "strength: must be finite, got nan"),
            (lambda: lagroid.RigidBody(inertia=[0, 1, 2]), "inertia: principal moments must be positive, got 0"),
            (lambda: lagroid.HeavyTop(inertia=[1, -1, 2]), "inertia: principal moments must be positive, got -1"),
            (lambda: lagroid.RigidBody(inertia=[1, 2, np.inf]), "inertia: must be finite, got inf"),
            (lambda: lagroid.RigidBody(inertia=[1, 2]), "inertia: expected 3 numbers, got 2"),
            (lambda: lagroid.HeavyTop(weight=[np.nan, 0, 1]), "weight: must be finite, got nan"),
            (lambda: lagroid.Pendulum(mass=-1), "mass: must be positive, got -1"),
            (lambda: lagroid.SphericalPendulum(length=0), "length: must be positive, got 0"),
            (lambda: lagroid.Pendulum(gravity=np.inf), "gravity: must be finite, got inf"),
            (lambda: lagroid.PlateBall(radius=0), "radius: must be positive, got 0"),
        ):
            with self.assertRaisesRegex(ValueError, f"^{message}$"):
                make()
        for wrong, message in (
            ({"tolerance": np.nan}, "tolerance: must be finite, got nan"),
            ({"tolerance": -1}, "tolerance: must be zero or positive, got -1"),
            ({"max_iterations": -1}, "max_iterations: must be from 0 to 100000, got -1"),
        ):
            with self.assertRaisesRegex(ValueError, f"^{message}$"):
                lagroid.Kepler().integrator(momentum=[0, 1], object=[1, 0], **wrong)  # type: ignore[arg-type]
        for steps, starts, message in ((1, 1, "steps: must be at least 2, got 1"), (9, 0, "starts: must be at least 1")):
            with self.assertRaisesRegex(ValueError, f"^{message}"):
                lagroid.Kepler().boundary([1, 0, 0, 1], steps, starts=starts)

    def test_parameters_of_the_wrong_type(self) -> None:
        body = lagroid.RigidBody()

        def assign() -> None:
            body.inertia = "heavy"

        for make, message in (
            (lambda: lagroid.Kepler(h="small"), "Kepler: h: expected a number, got str"),
            (lambda: lagroid.Kepler(strength=[1.0]), "Kepler: strength: expected a number, got list"),
            (lambda: lagroid.Kepler(quadrature=2), "Kepler: quadrature: expected a word, got int"),
            (assign, "RigidBody: inertia: expected 3 numbers, got str"),
            (lambda: lagroid.Kepler(integrator=3), "Kepler has no parameter integrator"),
            (lambda: lagroid.Kepler(groupoid="R"), "Kepler has no parameter groupoid"),
        ):
            with self.assertRaisesRegex(TypeError, f"^{message}$"):
                make()
        with self.assertRaises(AttributeError):
            body.mass = 3  # type: ignore[attr-defined]
        np.testing.assert_array_equal(body.inertia, lagroid.RigidBody().inertia)
        with self.assertRaises(ValueError):
            body.inertia[0] = -1  # what is read is read-only

    def test_what_a_derived_class_raises_is_raised(self) -> None:
        system = Stiff(gravity=2.0)
        system.softness = 0.25
        self.assertEqual(pickle.loads(pickle.dumps(system)).gravity, 4.0)
        with self.assertRaisesRegex(TypeError, "unsupported operand"):
            system.softness = "soft"  # type: ignore[assignment]

    def test_a_step_that_fails_changes_nothing(self) -> None:
        ball = lagroid.PlateBall(h=40.0)
        integrator = ball.integrator(momentum=[1, 1, 1, 1, 1], object=[0, 0])
        before = integrator.state
        with self.assertRaises(lagroid.SolveError) as caught:
            integrator.advance()
        self.assertNotEqual(caught.exception.status, "converged")
        self.assertIn("step 1", str(caught.exception))
        np.testing.assert_array_equal(integrator.state[1], before[1])
        trajectory = integrator.integrate(3)
        self.assertEqual((trajectory.steps, trajectory.converged), (0, False))
        with self.assertRaises(lagroid.SolveError):
            lagroid.require(trajectory)

    def test_boundary_values_are_those_of_scenes(self) -> None:
        run = lagroid.run(EXAMPLES / "kepler_boundary.toml")
        start, end = run["position"][0], run["position"][-1]
        system = lagroid.Kepler(h=float(run.time[1]), quadrature="trapezoid")
        paths = system.boundary(np.concatenate([start, end]), run.steps)
        costs = [path.cost for path in paths]
        self.assertEqual(costs, sorted(costs))
        self.assertAlmostEqual(min(costs), run.stationary_paths[0].cost, places=9)
        np.testing.assert_allclose(paths[0].object[-1], end, atol=1e-9)
        self.assertEqual(paths[0].momentum.shape, (run.steps + 1, 2))
        self.assertEqual(paths[0].arrow.shape, (run.steps, 4))

    def test_boundary_value_without_solution(self) -> None:
        ball = lagroid.PlateBall(h=0.05)
        far = ball.arrow([0, 0], [500, 0], turned(1.0))
        with self.assertRaisesRegex(lagroid.SolveError, "boundary value"):
            ball.boundary(far, 4, starts=1)

    def test_copies_and_pickles(self) -> None:
        system = lagroid.Pendulum(length=2.0, quadrature="trapezoid", h=0.3)
        other = copy.copy(system)
        other.length = 3.0
        self.assertEqual((system.length, other.length), (2.0, 3.0))
        self.assertEqual(copy.deepcopy(other).length, 3.0)
        again = pickle.loads(pickle.dumps(system))
        self.assertEqual((again.length, again.quadrature, again.h), (2.0, "trapezoid", 0.3))
        top = pickle.loads(pickle.dumps(lagroid.HeavyTop(inertia=[1, 2, 3], rotation="cayley")))
        np.testing.assert_array_equal(top.inertia, [1, 2, 3])
        self.assertEqual(top.rotation, "cayley")

    def test_copies_keep_the_class(self) -> None:
        system = Named("first", length=2.0)
        for other in (copy.copy(system), copy.deepcopy(system), pickle.loads(pickle.dumps(system))):
            self.assertIs(type(other), Named)
            self.assertEqual((other.name, other.length), ("first", 2.0))
            other.name = "second"
            self.assertEqual(system.name, "first")

    def test_an_integrators_pickle_goes_on_with_the_same_bits(self) -> None:
        for integrator in (
            lagroid.Kepler(h=0.1).integrator(momentum=[0, 1.2], object=[1, 0], order=8),
            lagroid.Kepler(h=0.1).integrator(momentum=[0, 1.2], object=[1, 0], mode="controlled"),
            lagroid.SphericalPendulum(h=0.05).integrator(momentum=[0, 0.5, 0], object=[1, 0, 0]),
            lagroid.RigidBody(inertia=[1, 2, 3], h=0.1).integrator(momentum=[1, 0.1, 2], configuration=turned(0.5)),
            lagroid.PlateBall(h=0.05).integrator(momentum=[0.5, 0.2, 0.1, 0.2, 0.3], object=[0.1, 0]),
            lagroid.Pendulum().integrator(momentum=[1], object=[0], ledger=False),
        ):
            integrator.integrate(30)
            for again in (pickle.loads(pickle.dumps(integrator)), copy.deepcopy(integrator)):
                self.assertEqual((again.index, again.time, again.method), (30, integrator.time, integrator.method))
                np.testing.assert_array_equal(again.arrow, integrator.arrow)
                self.assertEqual(*([entry.drift for entry in each.ledger] for each in (again, integrator)))
            rest, same = integrator.integrate(40), again.integrate(40)
            for name in ("time", "object", "momentum", "configuration", "multipliers", "step_size"):
                np.testing.assert_array_equal(getattr(rest, name), getattr(same, name))
            for one, other in zip(integrator.ledger, again.ledger):
                self.assertEqual((one.name, one.drift, one.verdict), (other.name, other.drift, other.verdict))

    def test_what_was_given_to_an_integrator_may_change(self) -> None:
        system, momentum = lagroid.Pendulum(h=0.1), np.array([1.0])
        integrator = system.integrator(momentum=momentum, object=[0])
        system.length, momentum[0] = 2.0, 5.0
        again = pickle.loads(pickle.dumps(integrator))
        np.testing.assert_array_equal(again.integrate(10).object, integrator.integrate(10).object)

    def test_a_damaged_pickle_is_refused(self) -> None:
        version, origin, state = lagroid.Kepler().integrator(momentum=[0, 1], object=[1, 0]).__reduce_ex__(2)[2]
        for kept, message in (
            (("0.0.1", origin, state), "pickled by lagroid 0.0.1, this is .*; begin it anew"),
            ((version, origin, state[:-3]), "another lagroid; begin it anew"),
            ((version, (lagroid.Kepler(), {**origin[1], "order": 8}), state), "another lagroid; begin it anew"),
        ):
            with self.assertRaisesRegex(ValueError, message):
                lagroid.Integrator.__new__(lagroid.Integrator).__setstate__(kept)  # type: ignore[attr-defined]

    def test_states_are_given_by_name(self) -> None:
        for make in (
            lambda: lagroid.Kepler().integrator([0, 1], [1, 0]),  # type: ignore[misc]
            lambda: lagroid.Kepler().integrator([0, 1], object=[1, 0]),  # type: ignore[misc]
            lambda: lagroid.Kepler().integrator(object=[1, 0]),  # type: ignore[call-arg]
        ):
            with self.assertRaisesRegex(TypeError, "^integrator: give momentum, and object or configuration, by name"):
                make()

    def test_what_is_of_scenes_names_what_it_takes(self) -> None:
        for ask in (lagroid.study, lagroid.check, lagroid.run, lagroid.methods):
            for given in (lagroid.Kepler(), lagroid.Kepler().integrator(momentum=[0, 1], object=[1, 0]), 3):
                with self.assertRaisesRegex(TypeError, f"^a scene is .*, not {type(given).__name__}: .*$"):
                    ask(given)  # type: ignore[operator]

    def test_one_thread_at_a_time(self) -> None:
        integrator = lagroid.Pendulum(h=0.01).integrator(momentum=[1], object=[0])
        started = threading.Event()

        def long() -> None:
            started.set()
            integrator.integrate(3_000_000, every=1_000_000)

        thread = threading.Thread(target=long)
        thread.start()
        started.wait()
        uses = {
            "advance": integrator.advance,
            "object": lambda: integrator.object,
            "state": lambda: integrator.state,
            "ledger": lambda: integrator.ledger,
            "quantity": lambda: integrator.quantity("energy"),
            "index": lambda: integrator.index,
            "time": lambda: integrator.time,
        }
        refused = dict.fromkeys(uses, 0)
        while thread.is_alive():
            for name, use in uses.items():
                try:
                    use()
                except RuntimeError as error:
                    self.assertIn("another thread", str(error))
                    refused[name] += 1
        thread.join()
        for name, times in refused.items():
            self.assertGreater(times, 0, name)


if __name__ == "__main__":
    unittest.main()
