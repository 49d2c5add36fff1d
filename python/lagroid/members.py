"""What is read of a Lagrangian written in Python; what looks like it and is not read is refused."""

from __future__ import annotations

import inspect
from difflib import get_close_matches
from typing import Any

import numpy as np

from .groupoids import Array, Arrow

__all__ = ["Members", "principles", "refuse_unread"]

principles = ("vakonomic", "nonholonomic")

_READ = ("groupoid", "h", "principle", "lagrangian", "constraint", "object_constraint", "forces", "annihilator")
_OPTION = "an option of compiled systems: prototypes make variational steps of order two and equal size"
_INSTEAD = {
    **dict.fromkeys(("step", "step_size", "time_step", "dt"), "the step is h"),
    **dict.fromkeys(("mode", "method", "order", "composition", "without_root"), _OPTION),
    **dict.fromkeys(("tolerance", "max_iterations"), "steps are solved to round-off"),
    **dict.fromkeys(("two_sided", "gradients"), "derivatives are numeric"),
    "time": "lagrangian(*arrow, start, step) is told the time at which the arrow starts",
    "quantities": "there is no ledger",
    "admissible": "arrows have no branches",
    "first_guess": "a step begins where the one before ended",
}


def refuse_unread(system: Any, base: type) -> None:
    """Refuses members beside those of `base` that the system's author may take to be read: misspelt ones, and those
    that compiled systems have. Names with a leading underscore are the author's own. Raises TypeError."""
    own = [name for each in type(system).__mro__ if each not in base.__mro__ for name in vars(each)]
    for name in [*own, *vars(system)]:
        if name.startswith("_") or name in _READ or hasattr(base, name):
            continue
        reason = _why_unread(name, getattr(system, name))
        if reason:
            raise TypeError(
                f"{type(system).__name__}: {name} is not read: {reason} (a member of your own is called _{name})"
            )


def _why_unread(name: str, value: Any) -> str | None:
    """What to tell the author of such a member; None where it looks like nothing that is read."""
    if name.lower() in _INSTEAD:
        return _INSTEAD[name.lower()]
    known = [each for each in _READ if isinstance(value, str) or each != "principle"]  # principal moments are none
    alike = get_close_matches(name.lower(), known, 1, 0.8) if len(name) > 1 else []
    if not alike and callable(value):  # holonomic_constraint, external_force
        alike = get_close_matches(name.lower().rpartition("_")[2], ("constraint", "forces", "annihilator"), 1, 0.8)
    return f"did you mean {alike[0]}?" if alike else None


def _numbers(name: str, value: Any, shape: tuple[int, ...]) -> Array:
    """Numbers of the given shape; () stands for any array of one number."""
    try:
        found = np.asarray(value)
    except ValueError:  # rows of unequal length
        found = np.asarray(None)
    if found.dtype.kind not in "biufc":
        raise ValueError(f"{name}: expected {_in_words(shape)}, got {value!r}")
    if (found.size != 1) if shape == () else (found.shape != shape):
        raise ValueError(f"{name}: expected {_in_words(shape)}, got an array {found.shape}")
    return found.reshape(shape)


def _in_words(shape: tuple[int, ...]) -> str:
    return "a number" if shape == () else f"an array {shape}"


class Members:
    """The functions of a system of rank n, over the step h that begins at the time `start`; what they return is
    checked. Raises ValueError or TypeError of one line."""

    def __init__(self, system: Any, base: type, unit: Arrow) -> None:
        self.system = system
        self.start = 0.0
        self._rank = int(system.groupoid.dimension)
        self.forced = self._is_own("forces", base)
        self._has_annihilator = self._is_own("annihilator", base)
        self.nonholonomic = system.principle == "nonholonomic"
        self._times = {name: self._times_of(name, len(unit)) for name in ("lagrangian", "constraint", "forces")}
        q = system.groupoid.target(unit)
        self.arrow_constraints = self._count("constraint", self._at("constraint", unit))
        self.object_constraints = self._count("object_constraint", system.object_constraint(q))
        if self.nonholonomic and self.arrow_constraints == 0:
            raise ValueError("principle: nonholonomic, but there is no constraint(*arrow)")
        if self._has_annihilator and not self.nonholonomic:
            raise ValueError('annihilator: is of nonholonomic constraints; set principle = "nonholonomic"')

    def lagrangian(self, g: Arrow) -> Array:
        """L, an array ()."""
        return _numbers("lagrangian", self._at("lagrangian", g), ())

    def constraint(self, g: Arrow) -> Array:
        """phi, (arrow_constraints,)."""
        return _numbers("constraint", np.atleast_1d(self._at("constraint", g)), (self.arrow_constraints,))

    def object_constraint(self, q: Array) -> Array:
        """C, (object_constraints,)."""
        values = np.atleast_1d(self.system.object_constraint(q))
        return _numbers("object_constraint", values, (self.object_constraints,))

    def forces(self, g: Arrow) -> tuple[Array, Array]:
        """f- and f+, (n,) each."""
        if not self.forced:
            return np.zeros(self._rank), np.zeros(self._rank)
        both = self._at("forces", g)
        if not isinstance(both, (tuple, list)) or len(both) != 2:
            raise ValueError(f"forces: expected two arrays ({self._rank},), at source and target, got {both!r}")
        source, target = (_numbers("forces", each, (self._rank,)) for each in both)
        return source, target

    def annihilator(self, q: Array) -> Array | None:
        """omega, (n, arrow_constraints), where it is written."""
        if not self._has_annihilator:
            return None
        return _numbers("annihilator", self.system.annihilator(q), (self._rank, self.arrow_constraints))

    def varied(self, g: Arrow) -> Array:
        """(L, phi), of which derivatives are taken."""
        return np.concatenate([self.lagrangian(g).reshape(1), self.constraint(g)])

    def _is_own(self, name: str, base: type) -> bool:
        """Whether it is written by the system's author."""
        return getattr(getattr(self.system, name), "__func__", None) is not getattr(base, name)

    def _at(self, name: str, g: Arrow) -> Any:
        times = (self.start, self.system.h)
        return getattr(self.system, name)(*g, *times[2 - self._times[name] :])

    def _times_of(self, name: str, parts: int) -> int:
        """How many of (start, step) the function takes after an arrow of so many parts: the last, both, or none."""
        function = getattr(self.system, name)
        if not callable(function):
            raise TypeError(f"{name}: expected a method, got {function!r}")
        found = inspect.signature(function).parameters.values()
        if any(each.kind is each.VAR_POSITIONAL for each in found):
            return 0
        positional = [each for each in found if each.kind in (each.POSITIONAL_ONLY, each.POSITIONAL_OR_KEYWORD)]
        least = sum(each.default is each.empty for each in positional)
        if least > parts + 2 or len(positional) < parts:
            raise TypeError(
                f"{name}: takes ({', '.join(each.name for each in positional)}), but an arrow has {parts} "
                f"part{'s' if parts > 1 else ''}, after which may come step, or start and step"
            )
        return max(0, least - parts)

    @staticmethod
    def _count(name: str, value: Any) -> int:
        """Of constraints, of which there may be one without an array around it."""
        values = np.atleast_1d(value)
        if values.dtype.kind not in "biufc" or values.ndim != 1:
            raise ValueError(f"{name}: expected an array of one dimension, got {value!r}")
        return len(values)
