"""Discrete Lagrangians written in Python, with numeric derivatives: to try an idea before it is compiled.

A step costs tens of evaluations of the Lagrangian, microseconds each rather than nanoseconds: docs/python.md has the
measured times. Where the Lagrangian can be evaluated at complex numbers its derivatives are those of the complex step,
exact to round-off; else they are central differences, extrapolated, good to about 1e-11 of the Lagrangian's size, which
is then as far as steps are solved."""

from __future__ import annotations

import copy
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, NoReturn

import numpy as np

from . import compat
from .errors import SolveError
from .groupoids import Array, Arrow, Groupoid, MatrixGroup, Pair
from .members import Members, principles, refuse_unread

__all__ = ["PrototypeIntegrator", "PrototypeTrajectory", "System"]


class System:
    """A discrete Lagrangian on a groupoid with what else moves it, written in Python, with the members that a System of
    C++ has::

        class MyPendulum(lagroid.System):
            groupoid = lagroid.Pair(1)
            h = 0.05
            def lagrangian(self, q0, q1):
                return (q1 - q0) @ (q1 - q0) / (2 * self.h) + self.h * np.cos((q0 + q1) / 2)[0]

    `lagrangian(*arrow)` returns a number; the others, where they are written, what their docstrings say. Each function
    of an arrow may take the step h as one more argument, or the time at which the arrow starts and the step.
    `principle` is "vakonomic", constraint(*arrow) = 0 restricts the paths that compete, or "nonholonomic", it restricts
    virtual displacements (docs/nonholonomic.md).

    `lagrangian` and `constraint` are evaluated at complex arrays too: np.abs, np.linalg.norm and comparisons spoil
    that, and cost digits and time. Keywords of the constructor set attributes of the class. Members that look like
    these and are not read, misspelt ones first, are refused with a TypeError when a trajectory begins. Steps are solved
    by Newton's method, written here."""

    groupoid: Groupoid
    h: float = 0.01
    principle: str = "vakonomic"

    def __init__(self, **parameters: Any) -> None:
        for name, value in parameters.items():
            if not hasattr(self, name):
                raise TypeError(f"{type(self).__name__} has no parameter {name}")
            setattr(self, name, value)

    def lagrangian(self, *arrow: Any, **_: Any) -> Any:
        """L(g), a number; what must be written."""
        raise NotImplementedError("write lagrangian(self, ...) of an arrow")

    def constraint(self, *arrow: Any, **_: Any) -> Any:
        """phi, (m,), zero on admissible arrows; none by default."""
        return np.zeros(0)

    def object_constraint(self, q: Any) -> Any:
        """C, (m,), zero at admissible objects; none by default."""
        return np.zeros(0)

    def forces(self, *arrow: Any, **_: Any) -> Any:
        """The pair of discrete forces f- and f+, (n,) each, halves of an impulse at source and target; none by
        default."""
        raise NotImplementedError

    def annihilator(self, q: Any) -> Any:
        """omega, (n, m), whose columns annihilate the virtual displacements at q of a nonholonomic system; by default
        half of dphi/dw - dphi/dv at the unit of q."""
        raise NotImplementedError

    def integrator(self, *, momentum: Any, object: Any = None, configuration: Any = None) -> PrototypeIntegrator:
        """At the state (object, momentum); `configuration` is the arrow that ends there, a tuple, or for a group the
        matrix. It has a copy of the system: parameters that are set later do not touch it."""
        return PrototypeIntegrator(self, momentum=momentum, object=object, configuration=configuration)

    def boundary(self, *_: Any, **__: Any) -> NoReturn:
        """Refused: prototypes only make steps."""
        raise NotImplementedError(
            f"{type(self).__name__}: prototypes have no boundary values; compile the system and bind_boundary "
            "(docs/python.md)"
        )


@dataclass
class PrototypeTrajectory:
    """The nodes of many steps."""

    status: str = "converged"
    message: str = ""
    steps: int = 0
    time: Array = field(default_factory=lambda: np.zeros(0))
    object: Array = field(default_factory=lambda: np.zeros(0))
    momentum: Array = field(default_factory=lambda: np.zeros(0))
    configuration: Arrow = ()
    multipliers: Array = field(default_factory=lambda: np.zeros(0))

    @property
    def converged(self) -> bool:
        """Whether every step was made."""
        return self.status == "converged"


def _difference(value: Callable[[Array], Array], direction: Array) -> Array:
    """The derivative of `value` at zero, by central differences and Richardson's extrapolation."""
    step = float(np.finfo(float).eps) ** 0.2

    def central(h: float) -> Array:
        return np.asarray((value(h * direction) - value(-h * direction)) / (2 * h))

    return np.asarray((4 * central(step / 2) - central(step)) / 3)


def _gradient(value: Callable[[Array], Array], n: int) -> Array:
    """Its derivatives at the zero of R^n, a row for each coordinate."""
    return np.array([_difference(value, d) for d in np.eye(n)])


class _Derivatives:
    """First derivatives of `value`, an array of numbers of an arrow, in displacements (v, w) of its ends."""

    def __init__(self, groupoid: Groupoid, value: Callable[[Arrow], Array]) -> None:
        self.groupoid = groupoid
        self.value = value
        self.complex: bool | None = None  # not known before the first arrow
        self.size = 0.0  # of what is differentiated, where differences are

    def _displaced(self, g: Arrow, by: Array) -> Array:
        n = self.groupoid.dimension
        return self.value(self.groupoid.translate(by[:n], g, by[n:]))

    def _complex_steps(self, g: Arrow) -> Array:
        tiny = 1e-100
        out = np.array([self._displaced(g, 1j * tiny * d) for d in np.eye(2 * self.groupoid.dimension)])
        if not np.iscomplexobj(out):
            raise TypeError
        return np.asarray(out.imag / tiny)

    def _differences(self, g: Arrow) -> Array:
        return _gradient(lambda by: self._displaced(g, by), 2 * self.groupoid.dimension)

    def __call__(self, g: Arrow) -> Array:
        """(2 n, numbers): a row for each displacement, of the source first."""
        if self.complex is None:
            self.complex = self._complex_step_holds(g)
        if self.complex:
            return self._complex_steps(g)
        self.size = float(np.abs(self.value(g)).max())
        return self._differences(g)

    def _complex_step_holds(self, g: Arrow) -> bool:
        """Whether the function is analytic as it is written, seen at a generic arrow near g."""
        n = self.groupoid.dimension
        off = 1e-3 * np.sin(1.0 + np.arange(2 * n))
        near = self.groupoid.translate(off[:n], g, off[n:])
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                by_complex = self._complex_steps(near)
        except (TypeError, ValueError, Warning):
            return False
        by_difference = self._differences(near)
        size = np.abs(by_difference).max(axis=0) + np.abs(self.value(near)) + 1e-300
        return bool((np.abs(by_complex - by_difference) <= 1e-7 * size).all())


class PrototypeIntegrator:
    """A trajectory in the making. A step that fails leaves everything as it was. It can be pickled where its system can
    be, and goes on with the same bits."""

    def __init__(
        self, system: System, *, momentum: Any, object: Any = None, configuration: Any = None
    ) -> None:
        refuse_unread(system, System)
        if system.principle not in principles:
            raise ValueError(f"principle: {system.principle!r} is none of {', '.join(principles)}")
        if not np.isfinite(system.h) or system.h == 0:
            raise ValueError("h: the step must be finite and not zero")
        self.system = copy.copy(system)
        self.groupoid = compat.groupoid(system.groupoid)
        self.index = 0
        if configuration is not None:
            if object is not None:
                raise ValueError("give object or configuration, not both: an arrow has its target")
            self.configuration = self._arrow(configuration)
        else:
            self.configuration = self.groupoid.unit(self._object(object))
        # As the last step left it: without the reaction at the object, which the next one solves for.
        self._momentum: Array = np.array(momentum, dtype=float).reshape(-1)
        if len(self._momentum) != self.groupoid.dimension:
            raise ValueError(f"momentum: expected {self.groupoid.dimension} numbers, got {len(self._momentum)}")
        for name, numbers in (("momentum", self._momentum), ("object", self.object)):
            if not np.isfinite(numbers).all():
                raise ValueError(f"{name}: must be finite")
        self.arrow = self.groupoid.unit(self.object)
        self._members = Members(self.system, System, self.arrow)
        self._derivatives = _Derivatives(self.groupoid, self._members.varied)
        self.multipliers: Array = np.zeros(self._members.arrow_constraints + self._members.object_constraints)
        off = float(np.abs(self._members.object_constraint(self.object)).max(initial=0.0))
        if not off <= 1e-8 * (1 + float(self.object @ self.object)):
            raise ValueError(f"object: off the constraint C(q) = 0 by {off:.6g}")

    def _object(self, given: Any) -> Array:
        """The coordinates of an object, of the number that the groupoid asks for, where that is known."""
        q = np.array([] if given is None else given, dtype=float).reshape(-1)
        if isinstance(self.groupoid, Pair):
            if given is None:
                raise ValueError("give object, or configuration, the arrow that ends there")
            if len(q) != self.groupoid.n:
                raise ValueError(f"object: expected {self.groupoid.n} numbers, got {len(q)}")
        if isinstance(self.groupoid, MatrixGroup) and len(q) != 0:
            raise ValueError(f"object: a group has none, got {len(q)} numbers")
        return q

    def _arrow(self, given: Any) -> Arrow:
        arrow = tuple(np.array(each, dtype=float) for each in (given if isinstance(given, tuple) else (given,)))
        shapes = [each.shape for each in arrow]
        if isinstance(self.groupoid, Pair):
            if shapes != [(self.groupoid.n,)] * 2:
                raise ValueError(f"configuration: expected the tuple of two arrays ({self.groupoid.n},), got {shapes}")
        if isinstance(self.groupoid, MatrixGroup):
            if shapes != [self.groupoid.basis.shape[1:]]:
                raise ValueError(f"configuration: expected a matrix {self.groupoid.basis.shape[1:]}, got {shapes}")
            if not np.isfinite(arrow[0]).all() or np.linalg.det(arrow[0]) == 0:
                raise ValueError("configuration: no arrow of the group, it has no inverse")
        return arrow

    @property
    def object(self) -> Array:
        """beta of the configuration."""
        return self.groupoid.target(self.configuration)

    @property
    def momentum(self) -> Array:
        """mu, with the part of the reaction at the object that makes the velocity there keep the constraints
        (constrained_momentum of the library). Raises SolveError where that is not determined."""
        self._members.start = self.time
        reaction = self._reaction(self.object)
        if not reaction.any():
            return self._momentum
        k, n = self._members.arrow_constraints, self.groupoid.dimension
        unit = self.groupoid.unit(self.object)
        gradient = self._derivatives(unit)
        at_rest = (gradient[n:, 0] - gradient[:n, 0]) / 2
        tangent = reaction.copy()
        if not self._members.nonholonomic:
            tangent[:, :k] = gradient[n:, 1:]
        off = np.concatenate([self._members.constraint(unit), self._members.object_constraint(self.object)])
        matrix = np.block([[-self._mixed(unit), tangent], [tangent.T, np.zeros((len(off), len(off)))]])
        try:
            found = np.linalg.solve(matrix, np.concatenate([self._momentum - at_rest, -off]))
        except np.linalg.LinAlgError:
            found = np.array([np.nan])
        if not np.isfinite(found).all():
            raise self._fail("singular", "no single velocity at the object keeps the constraints")
        return np.asarray(self._momentum - reaction @ found[n:])

    @property
    def time(self) -> float:
        """s"""
        return self.index * self.system.h

    @property
    def state(self) -> tuple[Array, Array]:
        """(object, momentum)."""
        return self.object, self.momentum

    def _mixed(self, g: Arrow) -> Array:
        """d2L/dv dw, (n, n)."""
        n = self.groupoid.dimension

        def target_gradient(v: Array) -> Array:
            return np.asarray(self._derivatives(self.groupoid.translate(v, g, np.zeros(n)))[n:, 0])

        return _gradient(target_gradient, n)

    def _reaction(self, q: Array) -> Array:
        """The covectors of the reactions at an object, (n, constraints): omega of nonholonomic constraints, nothing of
        vakonomic ones, whose multipliers are those of the arrow, and d(C o beta)/dw at the unit."""
        n, k = self.groupoid.dimension, self._members.arrow_constraints
        out = np.zeros((n, k + self._members.object_constraints))
        unit = self.groupoid.unit(q)
        if self._members.nonholonomic:
            written = self._members.annihilator(q)
            if written is None:
                gradient = self._derivatives(unit)
                written = (gradient[n:, 1:] - gradient[:n, 1:]) / 2
            out[:, :k] = written
        if self._members.object_constraints:

            def at(w: Array) -> Array:
                moved = self.groupoid.translate(np.zeros(n), unit, w)
                return self._members.object_constraint(self.groupoid.target(moved))

            out[:, k:] = _gradient(at, n)
        return out

    def _equations(self, g: Arrow, multipliers: Array, reaction: Array) -> tuple[Array, Array]:
        """F-(g, lambda) - mu, phi(g), C(beta(g)); and F+."""
        n, k = self.groupoid.dimension, self._members.arrow_constraints
        weights = np.concatenate([[1.0], np.zeros(k) if self._members.nonholonomic else multipliers[:k]])
        gradient = self._derivatives(g) @ weights
        at_source, at_target = self._members.forces(g)
        minus = -gradient[:n] - at_source - reaction @ multipliers
        constraints = [self._members.constraint(g), self._members.object_constraint(self.groupoid.target(g))]
        return np.concatenate([minus - self._momentum, *constraints]), gradient[n:] + at_target

    def _jacobian(self, g: Arrow, multipliers: Array, reaction: Array) -> Array:
        n = self.groupoid.dimension
        step = float(np.finfo(float).eps) ** (1 / 3)
        columns = []
        for d in np.eye(n):
            ends = [
                self._equations(self.groupoid.translate(np.zeros(n), g, s * d), multipliers, reaction)[0]
                for s in (step, -step)
            ]
            columns.append((ends[0] - ends[1]) / (2 * step))
        for d in np.eye(len(multipliers)):
            columns.append(
                self._equations(g, multipliers + d, reaction)[0] - self._equations(g, multipliers, reaction)[0]
            )
        return np.array(columns).T

    def _fail(self, status: str, why: str) -> SolveError:
        return SolveError(f"step {self.index + 1} (from t = {self.time:.6g}): {why}", status)

    def advance(self) -> None:
        """One step. Raises SolveError, with its status: singular, not_finite, stagnated or not_converged."""
        start = self.object
        # The last arrow carried on: for pairs from the object where it ended.
        n = self.groupoid.dimension
        g = self._carried(start)
        multipliers = self.multipliers.copy()
        self._members.start = self.time
        reaction = self._reaction(start)
        residual, plus = self._equations(g, multipliers, reaction)
        matrix = self._jacobian(g, multipliers, reaction)
        renewed = True
        for _ in range(60):
            size = np.linalg.norm(residual)
            if not np.isfinite(size) or not np.isfinite(matrix).all():
                raise self._fail("not_finite", "a number overflowed or became NaN; use a smaller step")
            if size <= self._floor(matrix, g):
                break
            try:
                correction = np.linalg.solve(matrix, -residual)
            except np.linalg.LinAlgError:
                raise self._fail(
                    "singular", "the step's matrix is singular, the system is not regular here"
                ) from None
            fraction = 1.0
            while True:
                to = self.groupoid.translate(np.zeros(n), g, fraction * correction[:n])
                with np.errstate(all="ignore"):
                    found, found_plus = self._equations(to, multipliers + fraction * correction[n:], reaction)
                if np.linalg.norm(found) < (1 - 0.1 * fraction) * size:
                    break
                fraction /= 2
                if fraction < 1e-4:
                    break
            if fraction < 1e-4:
                if size <= 1000 * self._floor(matrix, g):
                    break
                if renewed:
                    raise self._fail(
                        "stagnated", f"the iteration stagnated at residual {size:.3g}; use a smaller step"
                    )
                matrix = self._jacobian(g, multipliers, reaction)
                renewed = True
                continue
            slow = np.linalg.norm(found) > 0.1 * size
            g, residual, plus = to, found, found_plus
            multipliers = multipliers + fraction * correction[n:]
            renewed = bool(slow)
            if slow:
                matrix = self._jacobian(g, multipliers, reaction)
        else:
            raise self._fail("not_converged", "no convergence after 60 iterations; use a smaller step")
        # By increments, which leaves the residual of the solve out of the momentum.
        self._momentum = plus - residual[:n]
        self.arrow, self.multipliers = g, multipliers
        self.configuration = self.groupoid.multiply(self.configuration, g)
        self.index += 1

    def _carried(self, start: Array) -> Arrow:
        if self.index == 0:
            return self.groupoid.unit(start)
        if isinstance(self.groupoid, Pair):
            return (start, 2 * start - self.arrow[0])
        if isinstance(self.groupoid, MatrixGroup):
            return self.arrow
        return self.groupoid.unit(start)

    def _floor(self, matrix: Array, g: Arrow) -> float:
        """What rounding leaves of the equations: of their terms, and of the differences where those are taken."""
        eps = float(np.finfo(float).eps)
        coordinates = max([1.0, *(float(np.abs(each).max(initial=0.0)) for each in g)])
        own = 4 * eps * (float(np.abs(matrix).max()) * coordinates + float(np.abs(self._momentum).max(initial=0.0)))
        return own if self._derivatives.complex else own + 10 * float(eps**0.8) * self._derivatives.size

    def integrate(self, steps: int, every: int = 1) -> PrototypeTrajectory:
        """So many steps; every n-th node is recorded, and the last. A step that fails ends it: see the status."""
        if steps < 0:
            raise ValueError("steps: must not be negative")
        if every < 1:
            raise ValueError("every: must be at least 1")
        rows: list[tuple[float, Array, Array, Arrow, Array]] = []

        def record() -> None:
            rows.append((self.time, self.object, self.momentum, self.configuration, self.multipliers))

        out = PrototypeTrajectory()
        record()
        for k in range(1, steps + 1):
            try:
                self.advance()
            except SolveError as error:
                out.status, out.message = error.status, str(error)
                break
            out.steps = k
            if k % every == 0 or k == steps:
                record()
        out.time = np.array([row[0] for row in rows])
        out.object = np.array([row[1] for row in rows])
        out.momentum = np.array([row[2] for row in rows])
        out.configuration = tuple(np.array(each) for each in zip(*(row[3] for row in rows)))
        out.multipliers = np.array([row[4] for row in rows[1:]])
        return out
