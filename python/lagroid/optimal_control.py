"""Optimal control problems of scenes (docs/optimal_control.md)."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Optional

from . import _lagroid
from ._lagroid import ControlLoop, ControlResult
from .scenes import SceneLike, made

__all__ = ["ControlLoop", "ControlResult", "control", "control_loop"]


def control(
    scene: SceneLike,
    *,
    set: Optional[Mapping[str, Any]] = None,
    out: Optional[str | os.PathLike[str]] = None,
) -> ControlResult:
    """Solves the optimal control problem of a scene, as `lagroid control`; `out` is the folder for its files. Returns
    also where no start converged: see `status` and `message`. Raises SceneError where the scene is mistaken, and after
    Ctrl-C KeyboardInterrupt."""
    return _lagroid.control(made(scene, set), out)


def control_loop(scene: SceneLike, *, set: Optional[Mapping[str, Any]] = None) -> ControlLoop:
    """Model predictive control by a scene of `lagroid control`: its first plan is the cheapest that is found, and
    `advance(state)` makes the next one, a sample of the length of a stage later, from where the motion is by then.
    Samples are solved as `[loop]` of the scene says, if it has one; where `status` is not "converged" the control is that of
    the last iterate, within its bounds. Raises SceneError where the scene is mistaken."""
    return ControlLoop(made(scene, set))
