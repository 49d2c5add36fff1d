"""Groupoids whose arrows are tuples of arrays: what Lagrangians written in Python are functions on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

__all__ = ["SE2", "SE3", "SO3", "Array", "Arrow", "Groupoid", "MatrixGroup", "Pair"]

Array = NDArray[Any]
Arrow = tuple[Array, ...]


class Groupoid(Protocol):
    """What a prototype needs of a groupoid: arrows are tuples of arrays, the arguments of the Lagrangian."""

    @property
    def dimension(self) -> int:
        """The rank of its algebroid."""

    def unit(self, q: Array) -> Arrow:
        """The unit at q."""

    def target(self, g: Arrow) -> Array:
        """beta(g)."""

    def multiply(self, g: Arrow, h: Arrow) -> Arrow:
        """g h, of composable arrows."""

    def translate(self, v: Array, g: Arrow, w: Array) -> Arrow:
        """tau(v)^{-1} g tau(w), also for complex v, w of vanishing size."""


@dataclass(frozen=True)
class Pair:
    """R^n x R^n: arrows (q0, q1), arrays (n,)."""

    n: int

    @property
    def dimension(self) -> int:
        return self.n

    def unit(self, q: Array) -> Arrow:
        return (q, q)

    def target(self, g: Arrow) -> Array:
        return g[1]

    def multiply(self, g: Arrow, h: Arrow) -> Arrow:
        return (g[0], h[1])

    def translate(self, v: Array, g: Arrow, w: Array) -> Arrow:
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

    def unit(self, q: Array) -> Arrow:
        del q
        return (np.eye(self.basis.shape[1]),)

    def target(self, g: Arrow) -> Array:
        del g
        return np.zeros(0)

    def multiply(self, g: Arrow, h: Arrow) -> Arrow:
        return (g[0] @ h[0],)

    def translate(self, v: Array, g: Arrow, w: Array) -> Arrow:
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
