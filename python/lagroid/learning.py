"""Learning Hamiltonians on (T*S^2)^k from trajectories (docs/learning.md)."""

from __future__ import annotations

import math
from typing import Any, Optional

import numpy as np

from . import _lagroid
from ._lagroid import LearnedHamiltonian, Measures, Trajectories
from .errors import SolveError

__all__ = ["LearnedHamiltonian", "Measures", "Trajectories", "learn", "trajectories"]


def trajectories(
    *,
    chain: int = 1,
    masses: Any = 1.0,
    lengths: Any = 1.0,
    gravity: float = 1.0,
    count: int = 500,
    points: int = 5,
    duration: float = 0.1,
    noise: float = 0.0,
    seed: int = 0,
) -> Trajectories:
    """Random motions of a pendulum chain of so many links, to learn from: `count` trajectories of `points` points over
    `duration` s. Masses (kg) and lengths (m) are one for each link, or one for all. Equal seeds give equal bits."""
    return Trajectories.chain(
        np.array(np.broadcast_to(np.asarray(masses, dtype=float), chain)),
        np.array(np.broadcast_to(np.asarray(lengths, dtype=float), chain)),
        gravity=gravity,
        count=count,
        points=points,
        duration=duration,
        noise=noise,
        seed=seed,
    )


def learn(
    data: Trajectories,
    model: str = "network:8",
    *,
    begin: Optional[LearnedHamiltonian] = None,
    integrator: str = "commutator-free-4",
    substeps: int = 2,
    validation: float = 0.0,
    starts: int = 4,
    iterations: int = 100,
    seed: int = 1,
    enough: float = 0.0,
    seconds: float = math.inf,
    dissipation: bool = False,
) -> LearnedHamiltonian:
    """Fits H = p^T M(q)^{-1} p / 2 + V(q) on spheres, H(q, p) in R^2n, V or H "polynomial:DEGREE" or
    "network:UNITS[,UNITS...]", through an integrator with so many substeps between points of the data. `dissipation`: a
    friction -R q' too. `begin`: a model to go on from, in place of `starts`. The other keywords are the options of `lagroid learn`. Raises SolveError where nothing could be learned, KeyboardInterrupt
    after Ctrl-C."""
    learned = _lagroid.learn(
        data, model, begin, integrator, substeps, validation, starts, iterations, seed, enough, seconds, dissipation
    )
    if not learned.usable:
        raise SolveError(learned.message, learned.status)
    return learned
