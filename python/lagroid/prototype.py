"""Discrete Lagrangians written in Python, with numeric derivatives: to try an idea before it is compiled.

A step costs tens of evaluations of the Lagrangian, hundreds of microseconds each rather than nanoseconds: some thousand
times as slow as a compiled system (docs/python.md). Where the Lagrangian can be evaluated at complex numbers its
derivatives are those of the complex step, exact to round-off; else they are central differences, extrapolated, good to
about 1e-11 of the Lagrangian's size, which is then as far as steps are solved."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from .errors import SolveError

__all__ = [
    "SE2",
    "SE3",
    "SO3",
    "DiscreteLagrangian",
    "Groupoid",
    "MatrixGroup",
    "Pairs",
    "PrototypeIntegrator",
    "PrototypeMarch",
]

Array = NDArray[Any]


class Groupoid(Protocol):
    """What a prototype needs of a groupoid: arrows are tuples of arrays, the arguments of the Lagrangian."""

    @property
    def dimension(self) -> int:
        """The rank of its algebroid."""

    def unit(self, q: Array) -> tuple[Array, ...]:
        """The unit at q."""

    def target(self, g: tuple[Array, ...]) -> Array:
        """beta(g)."""

    def multiply(self, g: tuple[Array, ...], h: tuple[Array, ...]) -> tuple[Array, ...]:
        """g h, of composable arrows."""

    def displaced(self, g: tuple[Array, ...], v: Array, w: Array) -> tuple[Array, ...]:
        """tau(v)^{-1} g tau(w), also for complex v, w of vanishing size."""


@dataclass(frozen=True)
class Pairs:
    """R^n x R^n: arrows (q0, q1), arrays (n,)."""

    n: int

    @property
    def dimension(self) -> int:
        return self.n

    def unit(self, q: Array) -> tuple[Array, ...]:
        return (q, q)

    def target(self, g: tuple[Array, ...]) -> Array:
        return g[1]

    def multiply(self, g: tuple[Array, ...], h: tuple[Array, ...]) -> tuple[Array, ...]:
        return (g[0], h[1])

    def displaced(self, g: tuple[Array, ...], v: Array, w: Array) -> tuple[Array, ...]:
        return (g[0] + v, g[1] + w)


def _exponential(x: Array) -> Array:
    """exp(X) by Taylor's series, scaled and squared."""
    size = float(np.abs(x).sum(axis=1).max(initial=0.0))
    halvings = max(0, int(np.ceil(np.log2(size / 0.25)))) if size > 0.25 else 0
    y = x / 2.0**halvings
    total = np.eye(len(x), dtype=y.dtype)
    term = total
    for k in range(1, 14):
        term = term @ y / k
        total = total + term
    for _ in range(halvings):
        total = total @ total
    return total


class MatrixGroup:
    """A group of matrices over one object: arrows (g,), g an array (N, N); `basis` (n, N, N) of its algebra."""

    def __init__(self, basis: Any) -> None:
        self.basis: Array = np.asarray(basis, dtype=float)

    @property
    def dimension(self) -> int:
        return len(self.basis)

    def hat(self, v: Array) -> Array:
        """The element of the algebra with coordinates v (n,), an array (N, N)."""
        return np.tensordot(v, self.basis, axes=1)

    def exp(self, v: Array) -> Array:
        """exp(hat(v)), (N, N)."""
        return _exponential(self.hat(np.asarray(v)))

    def unit(self, q: Array) -> tuple[Array, ...]:
        del q
        return (np.eye(self.basis.shape[1]),)

    def target(self, g: tuple[Array, ...]) -> Array:
        del g
        return np.zeros(0)

    def multiply(self, g: tuple[Array, ...], h: tuple[Array, ...]) -> tuple[Array, ...]:
        return (g[0] @ h[0],)

    def displaced(self, g: tuple[Array, ...], v: Array, w: Array) -> tuple[Array, ...]:
        moved = g[0]
        if v.any():
            moved = self._near_unit(-v) @ moved
        if w.any():
            moved = moved @ self._near_unit(w)
        return (moved,)

    def _near_unit(self, v: Array) -> Array:
        """exp(hat(v)), whose square is nothing beside it where v is complex, of vanishing size."""
        if np.iscomplexobj(v):
            return np.asarray(np.eye(self.basis.shape[1]) + self.hat(v))
        return self.exp(v)


def _rotations(n: int) -> Array:
    basis = np.zeros((3, n, n))
    for i, (j, k) in enumerate(((1, 2), (2, 0), (0, 1))):
        basis[i, j, k] = -1
        basis[i, k, j] = 1
    return basis


def _translations(n: int) -> Array:
    basis = np.zeros((n, n + 1, n + 1))
    for i in range(n):
        basis[i, i, n] = 1
    return basis


def SO3() -> MatrixGroup:
    """Rotations, in coordinates of the rotation vector."""
    return MatrixGroup(_rotations(3))


def SE3() -> MatrixGroup:
    """Rigid motions of space, rotations first."""
    return MatrixGroup(np.concatenate([_rotations(4), _translations(3)]))


def SE2() -> MatrixGroup:
    """Rigid motions of the plane, the rotation first."""
    return MatrixGroup(np.concatenate([_rotations(3)[2:], _translations(2)]))


class DiscreteLagrangian:
    """A discrete Lagrangian on a groupoid, written in Python::

        class MyPendulum(lagroid.DiscreteLagrangian):
            groupoid = lagroid.Pairs(1)
            h = 0.05
            def lagrangian(self, q0, q1):
                return (q1 - q0) @ (q1 - q0) / (2 * self.h) + self.h * np.cos((q0 + q1) / 2)[0]

    `lagrangian(*arrow)` returns a number. `constraint(*arrow)`, where there is one, an array phi with phi(g) = 0 for
    the arrows of the paths that compete (vakonomic); `object_constraint(q)` an array C with C(q) = 0. They are
    evaluated at complex arrays too: np.abs, np.linalg.norm and comparisons spoil that, and cost digits and time.
    Keywords of the constructor set attributes of the class. Steps are solved by Newton's method, written here."""

    groupoid: Groupoid
    h: float = 0.01
    principle = "vakonomic"

    def __init__(self, **parameters: Any) -> None:
        for name, value in parameters.items():
            if not hasattr(self, name):
                raise TypeError(f"{type(self).__name__} has no parameter {name}")
            setattr(self, name, value)

    def lagrangian(self, *arrow: Any, **_: Any) -> Any:
        """L(g), a number; what must be written."""
        raise NotImplementedError("write lagrangian(self, ...) of an arrow")

    def constraint(self, *arrow: Any, **_: Any) -> Any:
        """phi, (m,); none by default."""
        return np.zeros(0)

    def object_constraint(self, q: Any) -> Any:
        """C, (m,); none by default."""
        return np.zeros(0)

    def integrator(self, momentum: Any, object: Any = None, *, configuration: Any = None) -> PrototypeIntegrator:
        """At the state (object, momentum); `configuration` is the arrow that ends there, a tuple, or for a group the
        matrix."""
        return PrototypeIntegrator(self, momentum, object, configuration)


@dataclass
class PrototypeMarch:
    """The nodes of many steps."""

    status: str = "converged"
    message: str = ""
    steps: int = 0
    time: Array = field(default_factory=lambda: np.zeros(0))
    object: Array = field(default_factory=lambda: np.zeros(0))
    momentum: Array = field(default_factory=lambda: np.zeros(0))
    configuration: tuple[Array, ...] = ()
    multipliers: Array = field(default_factory=lambda: np.zeros(0))

    @property
    def converged(self) -> bool:
        """Whether every step was made."""
        return self.status == "converged"


class _Derivatives:
    """First derivatives of f = (L, phi) in displacements (v, w) of the ends of an arrow."""

    def __init__(self, system: DiscreteLagrangian) -> None:
        self.system = system
        self.complex: bool | None = None  # not known before the first arrow
        self.size = 0.0  # of what is differentiated, where differences are

    def value(self, g: tuple[Array, ...]) -> Array:
        lagrangian = np.asarray(self.system.lagrangian(*g))
        if lagrangian.size != 1 or lagrangian.dtype.kind not in "biufc":
            found = f"an array {lagrangian.shape}" if lagrangian.dtype.kind in "biufc" else f"{lagrangian.item()!r}"
            raise ValueError(f"lagrangian: expected a number, got {found}")
        return np.concatenate([lagrangian.ravel(), np.atleast_1d(self.system.constraint(*g)).ravel()])

    def _along(self, g: tuple[Array, ...], direction: Array) -> Array:
        n = self.system.groupoid.dimension
        tiny = 1e-100
        moved = self.system.groupoid.displaced(g, 1j * tiny * direction[:n], 1j * tiny * direction[n:])
        out = self.value(moved)
        if not np.iscomplexobj(out):
            raise TypeError
        return np.asarray(out.imag / tiny)

    def _difference(self, g: tuple[Array, ...], direction: Array) -> Array:
        n = self.system.groupoid.dimension
        step = float(np.finfo(float).eps) ** 0.2

        def central(h: float) -> Array:
            ends = [
                self.value(self.system.groupoid.displaced(g, s * direction[:n], s * direction[n:])) for s in (h, -h)
            ]
            return np.asarray((ends[0] - ends[1]) / (2 * h))

        return np.asarray((4 * central(step / 2) - central(step)) / 3)

    def __call__(self, g: tuple[Array, ...]) -> Array:
        """(2 n, 1 + m): a row for each displacement, of the source first."""
        directions = np.eye(2 * self.system.groupoid.dimension)
        if self.complex is None:
            self.complex = self._complex_step_holds(g, directions)
        along = self._along if self.complex else self._difference
        if not self.complex:
            self.size = float(np.abs(self.value(g)).max())
        return np.array([along(g, d) for d in directions])

    def _complex_step_holds(self, g: tuple[Array, ...], directions: Array) -> bool:
        """Whether the function is analytic as it is written, seen at a generic arrow near g."""
        n = self.system.groupoid.dimension
        off = 1e-3 * np.sin(1.0 + np.arange(2 * n))
        near = self.system.groupoid.displaced(g, off[:n], off[n:])
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                by_complex = np.array([self._along(near, d) for d in directions])
        except (TypeError, ValueError, Warning):
            return False
        by_difference = np.array([self._difference(near, d) for d in directions])
        size = np.abs(by_difference).max(axis=0) + np.abs(self.value(near)) + 1e-300
        return bool((np.abs(by_complex - by_difference) <= 1e-7 * size).all())


class PrototypeIntegrator:
    """A trajectory in the making. A step that fails leaves everything as it was."""

    def __init__(self, system: DiscreteLagrangian, momentum: Any, object: Any, configuration: Any) -> None:
        self.system = system
        self.groupoid = system.groupoid
        self.index = 0
        self._derivatives = _Derivatives(system)
        if configuration is not None:
            if object is not None:
                raise ValueError("give object or configuration, not both: an arrow has its target")
            self.configuration = self._arrow(configuration)
        else:
            self.configuration = self.groupoid.unit(self._object(object))
        self.momentum: Array = np.array(momentum, dtype=float).reshape(-1)
        if len(self.momentum) != self.groupoid.dimension:
            raise ValueError(f"momentum: expected {self.groupoid.dimension} numbers, got {len(self.momentum)}")
        for name, numbers in (("momentum", self.momentum), ("object", self.object)):
            if not np.isfinite(numbers).all():
                raise ValueError(f"{name}: must be finite")
        if not np.isfinite(system.h) or system.h == 0:
            raise ValueError("h: the step must be finite and not zero")
        unit = self.groupoid.unit(self.object)
        self._arrow_constraints = len(np.atleast_1d(system.constraint(*unit)))
        self._object_constraints = len(np.atleast_1d(system.object_constraint(self.object)))
        self.arrow = unit
        self.multipliers: Array = np.zeros(self._arrow_constraints + self._object_constraints)

    def _object(self, given: Any) -> Array:
        """The coordinates of an object, of the number that the groupoid asks for, where that is known."""
        q = np.array([] if given is None else given, dtype=float).reshape(-1)
        if isinstance(self.groupoid, Pairs):
            if given is None:
                raise ValueError("give object, or configuration, the arrow that ends there")
            if len(q) != self.groupoid.n:
                raise ValueError(f"object: expected {self.groupoid.n} numbers, got {len(q)}")
        if isinstance(self.groupoid, MatrixGroup) and len(q) != 0:
            raise ValueError(f"object: a group has none, got {len(q)} numbers")
        return q

    def _arrow(self, given: Any) -> tuple[Array, ...]:
        arrow = tuple(np.array(each, dtype=float) for each in (given if isinstance(given, tuple) else (given,)))
        shapes = [each.shape for each in arrow]
        if isinstance(self.groupoid, Pairs):
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
    def time(self) -> float:
        """s"""
        return self.index * self.system.h

    @property
    def state(self) -> tuple[Array, Array]:
        """(object, momentum)."""
        return self.object, self.momentum

    def _object_gradient(self, q: Array) -> Array:
        """d(C o beta)/dw at the unit of q, (n, m)."""
        if self._object_constraints == 0:
            return np.zeros((self.groupoid.dimension, 0))
        n = self.groupoid.dimension
        step = float(np.finfo(float).eps) ** 0.2
        unit = self.groupoid.unit(q)

        def at(w: Array) -> Array:
            return np.asarray(self.system.object_constraint(self.groupoid.target(
                self.groupoid.displaced(unit, np.zeros(n), w))))

        def central(d: Array, h: float) -> Array:
            return np.asarray((at(h * d) - at(-h * d)) / (2 * h))

        return np.array([(4 * central(d, step / 2) - central(d, step)) / 3 for d in np.eye(n)])

    def _equations(self, g: tuple[Array, ...], multipliers: Array, reaction: Array) -> tuple[Array, Array]:
        """F-(g, lambda) - mu, phi(g), C(beta(g)); and F+."""
        n = self.groupoid.dimension
        weights = np.concatenate([[1.0], multipliers[: self._arrow_constraints]])
        gradient = self._derivatives(g) @ weights
        minus = -gradient[:n] - reaction @ multipliers[self._arrow_constraints :]
        constraints = [np.atleast_1d(self.system.constraint(*g)), np.atleast_1d(
            self.system.object_constraint(self.groupoid.target(g)))]
        return np.concatenate([minus - self.momentum, *constraints]), gradient[n:]

    def _jacobian(self, g: tuple[Array, ...], multipliers: Array, reaction: Array) -> Array:
        n = self.groupoid.dimension
        step = float(np.finfo(float).eps) ** (1 / 3)
        columns = []
        for d in np.eye(n):
            ends = [
                self._equations(self.groupoid.displaced(g, np.zeros(n), s * d), multipliers, reaction)[0]
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
        reaction = self._object_gradient(start)
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
                to = self.groupoid.displaced(g, np.zeros(n), fraction * correction[:n])
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
        self.momentum = plus - residual[:n]
        self.arrow, self.multipliers = g, multipliers
        self.configuration = self.groupoid.multiply(self.configuration, g)
        self.index += 1

    def _carried(self, start: Array) -> tuple[Array, ...]:
        if self.index == 0:
            return self.groupoid.unit(start)
        if isinstance(self.groupoid, Pairs):
            return (start, 2 * start - self.arrow[0])
        if isinstance(self.groupoid, MatrixGroup):
            return self.arrow
        return self.groupoid.unit(start)

    def _floor(self, matrix: Array, g: tuple[Array, ...]) -> float:
        """What rounding leaves of the equations: of their terms, and of the differences where those are taken."""
        eps = float(np.finfo(float).eps)
        coordinates = max([1.0, *(float(np.abs(each).max(initial=0.0)) for each in g)])
        own = 4 * eps * (float(np.abs(matrix).max()) * coordinates + float(np.abs(self.momentum).max(initial=0.0)))
        return own if self._derivatives.complex else own + 10 * float(eps**0.8) * self._derivatives.size

    def march(self, steps: int, every: int = 1) -> PrototypeMarch:
        """So many steps; every n-th node is recorded, and the last. A step that fails ends it: see the status."""
        if steps < 0:
            raise ValueError("steps: must not be negative")
        if every < 1:
            raise ValueError("every: must be at least 1")
        rows: list[tuple[float, Array, Array, tuple[Array, ...], Array]] = []

        def record() -> None:
            rows.append((self.time, self.object, self.momentum, self.configuration, self.multipliers))

        out = PrototypeMarch()
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
