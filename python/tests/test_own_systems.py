"""The template project's system, in a module of its own."""

import pickle
import unittest

import lagroid
import my_system
import numpy as np


class OwnSystems(unittest.TestCase):
    def test_parameters(self) -> None:
        bead = my_system.Bead(mass=2.0, bend=0.5, h=0.02)
        self.assertEqual((bead.mass, bead.bend, bead.gravity, bead.h), (2.0, 0.5, 1.0, 0.02))
        with self.assertRaisesRegex(TypeError, "Bead has no parameter length"):
            my_system.Bead(length=1)
        with self.assertRaisesRegex(TypeError, "^Bead: mass: expected a number, got str$"):
            my_system.Bead(mass="heavy")
        again = pickle.loads(pickle.dumps(bead))
        self.assertEqual((again.mass, again.bend, again.gravity, again.h), (2.0, 0.5, 1.0, 0.02))

    def test_integrates_with_a_ledger(self) -> None:
        integrator = my_system.Bead(h=0.05).integrator(momentum=[0.0], object=[1.0])
        self.assertIsInstance(integrator, lagroid.Integrator)
        trajectory = lagroid.require(integrator.integrate(2000))
        self.assertEqual(trajectory.object.shape, (2001, 1))
        self.assertEqual([entry.verdict for entry in integrator.ledger], ["bounded"])
        self.assertLess(np.ptp(trajectory.quantities["energy"]), 1e-3)

    def test_integrators_are_pickled_and_resumed(self) -> None:
        integrator = my_system.Bead(bend=0.5, h=0.05).integrator(momentum=[0.0], object=[1.0], order=4)
        integrator.integrate(100)
        again = pickle.loads(pickle.dumps(integrator))
        np.testing.assert_array_equal(again.integrate(100).object, integrator.integrate(100).object)
        self.assertEqual([e.drift for e in again.ledger], [e.drift for e in integrator.ledger])

    def test_what_is_of_scenes_refuses_it_in_one_line(self) -> None:
        for ask in (lagroid.study, lagroid.check):
            with self.assertRaisesRegex(TypeError, "^a scene is .*, not Bead: .* a system of your own has integrator"):
                ask(my_system.Bead())

    def test_no_verdict_on_numbers_that_are_none(self) -> None:
        for mass in (1e-320, 1e-300, 1e-170, 1e-160, 1e160, 1e200, 1e300):
            integrator = my_system.Bead(h=0.05, mass=mass).integrator(momentum=[mass], object=[0.0])
            trajectory = integrator.integrate(2000)
            (energy,) = integrator.ledger
            if energy.verdict == "bounded":
                self.assertTrue(trajectory.converged, mass)
                self.assertLess(energy.relative_drift, 0.5, mass)
                self.assertLess(abs(trajectory.object).max(), 3, mass)
            else:
                self.assertIn(energy.verdict, ("BROKEN", "unjudged"), mass)
                self.assertNotEqual(energy.reason, "", mass)
        bead = lagroid.require(my_system.Bead(h=0.05, mass=1e120).integrator(momentum=[1e120], object=[0.0]).integrate(2000))
        same = lagroid.require(my_system.Bead(h=0.05).integrator(momentum=[1.0], object=[0.0]).integrate(2000))
        np.testing.assert_allclose(bead.object, same.object, atol=1e-9)

    def test_is_the_prototype(self) -> None:
        class Bead(lagroid.System):
            groupoid = lagroid.Pair(1)
            h = 0.05

            def lagrangian(self, q0, q1):  # type: ignore[no-untyped-def]
                y0, y1 = q0**2 / 2, q1**2 / 2
                return (((q1 - q0) ** 2 + (y1 - y0) ** 2) / (2 * self.h) - self.h * (y0 + y1) / 2)[0]

        compiled = my_system.Bead(h=0.05).integrator(momentum=[0.3], object=[1.0]).integrate(100)
        prototype = Bead().integrator(momentum=[0.3], object=[1.0]).integrate(100)
        np.testing.assert_allclose(prototype.object, compiled.object, atol=1e-12)

    def test_a_broken_bead_is_another_one(self) -> None:
        """The comparison above can fail."""
        one = my_system.Bead(h=0.05).integrator(momentum=[0.3], object=[1.0]).integrate(100)
        other = my_system.Bead(h=0.05, gravity=1.001).integrator(momentum=[0.3], object=[1.0]).integrate(100)
        self.assertGreater(np.abs(one.object - other.object).max(), 1e-4)

    def test_high_order_and_other_modes(self) -> None:
        bead = my_system.Bead(h=0.1)
        exact = my_system.Bead(h=0.01).integrator(momentum=[0.3], object=[1.0], order=8).integrate(100).object[-1, 0]
        errors = [
            abs(bead.integrator(momentum=[0.3], object=[1.0], order=order).integrate(10).object[-1, 0] - exact) for order in (2, 4, 8)
        ]
        self.assertGreater(errors[0], 20 * errors[1])
        self.assertGreater(errors[1], 20 * errors[2])
        with self.assertRaises(ValueError):
            bead.integrator(momentum=[0.3], object=[1.0], method="splitting")


if __name__ == "__main__":
    unittest.main()
