"""Minimising functions on manifolds (docs/optimisation.md)."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from . import _lagroid
from ._lagroid import FrechetMean, HyperbolicSpace, Manifold, Optimum, PositiveDefinite, ProductManifold, Sphere, Stiefel
from .scenes import SceneLike, made, scene_text

__all__ = [
    "FrechetMean",
    "HyperbolicSpace",
    "Manifold",
    "Optimum",
    "PositiveDefinite",
    "ProductManifold",
    "Sphere",
    "Stiefel",
    "minimise",
    "optimize",
]

Array = NDArray[np.float64]


def optimize(
    scene: SceneLike,
    *,
    set: Optional[Mapping[str, Any]] = None,
    history: bool = True,
    out: Optional[str | os.PathLike[str]] = None,
) -> Optimum:
    """Minimises the function of a scene, as `lagroid optimize`. Files that the scene names are looked for beside it.
    Returns also where it did not converge: see `status` and `message`."""
    return _lagroid.optimise(made(scene, set), history, out)


def minimise(
    manifold: Manifold,
    fun: Callable[[Array], tuple[float, Any]],
    start: Optional[Any] = None,
    *,
    method: str | Mapping[str, Any] = "trust-region",
    hessian: Optional[Callable[[Array, Array], Any]] = None,
    seed: int = 1,
    gradient: float = 0.0,
    relative_gradient: float = 1e-8,
    iterations: int = 10000,
    seconds: float = math.inf,
    history: bool = True,
) -> Optimum:
    """Minimises a function of your own.

    `fun(x)` returns the value and the gradient in the space around the manifold, an array of the shape of x: (n,) on a
    sphere, (n, m) on a Stiefel manifold, (size,) on a product. It may keep x. `hessian(x, v)`, of the same shape,
    is by default the central difference of gradients. What it raises is raised here. A FrechetMean is computed in C++.

    `start` is a point, or drawn by `seed`; of a FrechetMean it is the first of its points. `method` is the name of one, or what [method] of a scene holds
    (docs/optimisation.md). It stops where the norm of the Riemannian gradient is at most `gradient`, or
    `relative_gradient` times the one at the start. Ctrl-C raises KeyboardInterrupt."""
    keys = {"name": method} if isinstance(method, str) else method
    return _lagroid.minimise(
        manifold, fun, start, scene_text(keys), hessian, seed, gradient, relative_gradient, iterations, seconds, history
    )
