"""Names that were retired, each until the minor version after the next; what uses one is told the new one.

CHANGELOG.md has the table of old and new."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any

from .groupoids import Array, Arrow, Groupoid

__all__ = ["NAMES", "attribute", "groupoid", "keep_march"]

#: Of the package, which go with 0.4.
NAMES = {
    "BoundaryPath": "BoundarySolution",
    "DiscreteLagrangian": "System",
    "March": "Trajectory",
    "Minimum": "StationaryPath",
    "Pairs": "Pair",
    "Product": "ProductManifold",
    "PrototypeMarch": "PrototypeTrajectory",
    "Run": "RunResult",
}


def attribute(name: str, package: Mapping[str, object]) -> object:
    """What the package calls otherwise now, for its __getattr__. Raises AttributeError for what it never had."""
    if name not in NAMES:
        raise AttributeError(f"module 'lagroid' has no attribute '{name}'")
    warnings.warn(f"lagroid.{name} is lagroid.{NAMES[name]}", DeprecationWarning, stacklevel=3)
    return package[NAMES[name]]


def _march(self: Any, steps: int, every: int = 1) -> Any:
    """march(steps, every=1)

    What integrate was called in version 0.2."""
    name = type(self).__name__
    warnings.warn(f"{name}.march is {name}.integrate", DeprecationWarning, stacklevel=2)
    return self.integrate(steps, every)


def keep_march(*integrators: type) -> None:
    """Gives these classes the method by which 0.2 integrated."""
    for each in integrators:
        setattr(each, "march", _march)  # noqa: B010


class _Translating:
    """A groupoid that was written when `translate(v, g, w)` was `displaced(g, v, w)`."""

    def __init__(self, written: Any) -> None:
        self._written = written

    @property
    def dimension(self) -> int:
        return int(self._written.dimension)

    def unit(self, q: Array) -> Arrow:
        unit: Arrow = self._written.unit(q)
        return unit

    def target(self, g: Arrow) -> Array:
        target: Array = self._written.target(g)
        return target

    def multiply(self, g: Arrow, h: Arrow) -> Arrow:
        product: Arrow = self._written.multiply(g, h)
        return product

    def translate(self, v: Array, g: Arrow, w: Array) -> Arrow:
        translated: Arrow = self._written.displaced(g, v, w)
        return translated


def groupoid(given: Any) -> Groupoid:
    """It, or one of the same arrows that can be translated."""
    if not hasattr(given, "displaced"):
        found: Groupoid = given
        return found
    # Who called integrator(...) of the system is to see it.
    message = f"{type(given).__name__}.displaced(g, v, w) is translate(v, g, w)"
    warnings.warn(message, DeprecationWarning, stacklevel=4)
    return _Translating(given)
