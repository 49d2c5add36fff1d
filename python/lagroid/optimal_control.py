"""Optimal control problems of scenes (docs/optimal_control.md)."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Optional

from . import _lagroid
from ._lagroid import ControlResult
from .scenes import SceneLike, made

__all__ = ["ControlResult", "control"]


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
