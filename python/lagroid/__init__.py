"""Lagroid in Python: discrete mechanics on Lie groupoids (docs/python.md).

    import lagroid
    run = lagroid.run("examples/kepler.toml", set={"time.steps": 1000})
    run["x"], run["drift energy"], run.ledger
"""

from typing import TYPE_CHECKING

from . import _lagroid, compat, plot
from ._lagroid import *  # the systems, a class each
from ._lagroid import (
    BoundarySolution,
    Columns,
    Endpoint,
    EventNode,
    Integrator,
    LedgerEntry,
    Panel,
    RunResult,
    StationaryPath,
    Trajectory,
    __version__,
)
from .errors import DataError, Error, Interrupted, OutputError, ProgramError, SceneError, SolveError
from .groupoids import SE2, SE3, SO3, Groupoid, MatrixGroup, Pair
from .learning import LearnedHamiltonian, Measures, Trajectories, learn, trajectories
from .optimal_control import ControlLoop, ControlResult, control, control_loop
from .optimisation import (
    FrechetMean,
    HyperbolicSpace,
    Manifold,
    Optimum,
    PositiveDefinite,
    ProductManifold,
    Sphere,
    Stiefel,
    minimise,
    optimize,
)
from .prototype import PrototypeIntegrator, PrototypeTrajectory, System
from .scenes import reductions, require, resume, run, scene_text, systems
from .studies import GradientTable, Method, Uncertainty, check, fit, gradient, methods, study, uncertainty
from .sweeps import Sweep, sweep

__all__ = [
    "BoundarySolution",
    "Columns",
    "ControlLoop",
    "ControlResult",
    "DataError",
    "Endpoint",
    "Error",
    "EventNode",
    "FrechetMean",
    "GradientTable",
    "Groupoid",
    "HyperbolicSpace",
    "Integrator",
    "Interrupted",
    "LearnedHamiltonian",
    "LedgerEntry",
    "Manifold",
    "MatrixGroup",
    "Measures",
    "Method",
    "Optimum",
    "OutputError",
    "Pair",
    "Panel",
    "PositiveDefinite",
    "ProductManifold",
    "ProgramError",
    "PrototypeIntegrator",
    "PrototypeTrajectory",
    "RunResult",
    "SE2",
    "SE3",
    "SO3",
    "SceneError",
    "SolveError",
    "Sphere",
    "StationaryPath",
    "Stiefel",
    "Sweep",
    "System",
    "Trajectories",
    "Trajectory",
    "Uncertainty",
    "__version__",
    "check",
    "fit",
    "gradient",
    "learn",
    "methods",
    "minimise",
    "optimize",
    "plot",
    "reductions",
    "require",
    "resume",
    "run",
    "scene_text",
    "study",
    "sweep",
    "systems",
    "trajectories",
    "uncertainty",
]

__all__ += _lagroid.__all__

compat.keep_march(Integrator, PrototypeIntegrator)

if not TYPE_CHECKING:  # which would believe that everything is there

    def __getattr__(name: str) -> object:
        return compat.attribute(name, globals())
