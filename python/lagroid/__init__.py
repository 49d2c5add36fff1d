"""Lagroid in Python: discrete mechanics on Lie groupoids (docs/python.md).

    import lagroid
    run = lagroid.run("examples/kepler.toml", set={"time.steps": 1000})
    run["x"], run["drift energy"], run.ledger
"""

import warnings

from . import _lagroid, plot
from ._lagroid import (
    AttitudeControl,
    BoundaryPath,
    ChaplyginSleigh,
    Columns,
    DampedPendulum,
    DrivenBody,
    DrivenPendulum,
    Endpoint,
    Gyrostat,
    HeavyTop,
    Integrator,
    Kepler,
    LedgerEntry,
    Panel,
    Pendulum,
    PlateBall,
    RigidBody,
    RollingBall,
    RollingDisk,
    Run,
    SphericalPendulum,
    StationaryPath,
    Trajectory,
    Unicycle,
    __version__,
)
from .errors import DataError, Error, Interrupted, OutputError, ProgramError, SceneError, SolveError
from .groupoids import SE2, SE3, SO3, Groupoid, MatrixGroup, Pairs
from .learning import LearnedHamiltonian, Measures, Trajectories, learn, trajectories
from .optimisation import Manifold, Optimum, Product, Sphere, Stiefel, minimise, optimize
from .prototype import DiscreteLagrangian, PrototypeIntegrator, PrototypeTrajectory
from .scenes import require, resume, run, scene_text, systems
from .studies import Method, check, methods, study
from .sweeps import Sweep, sweep

__all__ = [
    "AttitudeControl",
    "BoundaryPath",
    "ChaplyginSleigh",
    "Columns",
    "DampedPendulum",
    "DataError",
    "DiscreteLagrangian",
    "DrivenBody",
    "DrivenPendulum",
    "Endpoint",
    "Error",
    "Groupoid",
    "Gyrostat",
    "HeavyTop",
    "Integrator",
    "Interrupted",
    "Kepler",
    "LearnedHamiltonian",
    "LedgerEntry",
    "Manifold",
    "MatrixGroup",
    "Measures",
    "Method",
    "Optimum",
    "OutputError",
    "Pairs",
    "Panel",
    "Pendulum",
    "PlateBall",
    "Product",
    "ProgramError",
    "PrototypeIntegrator",
    "PrototypeTrajectory",
    "RigidBody",
    "RollingBall",
    "RollingDisk",
    "Run",
    "SE2",
    "SE3",
    "SO3",
    "SceneError",
    "SolveError",
    "Sphere",
    "SphericalPendulum",
    "StationaryPath",
    "Stiefel",
    "Sweep",
    "Trajectories",
    "Trajectory",
    "Unicycle",
    "__version__",
    "check",
    "learn",
    "methods",
    "minimise",
    "optimize",
    "plot",
    "require",
    "resume",
    "run",
    "scene_text",
    "study",
    "sweep",
    "systems",
    "trajectories",
]

# Systems that are not named above, each a class.
for _name in _lagroid.system_classes:
    globals()[_name] = getattr(_lagroid, _name)
    if _name not in __all__:
        __all__.append(_name)

# Names of version 0.2, which go with 0.4.
_renamed = {"March": "Trajectory", "Minimum": "StationaryPath", "PrototypeMarch": "PrototypeTrajectory"}


def __getattr__(name: str) -> object:
    if name in _renamed:
        warnings.warn(f"lagroid.{name} is lagroid.{_renamed[name]}", DeprecationWarning, stacklevel=2)
        return globals()[_renamed[name]]
    raise AttributeError(f"module 'lagroid' has no attribute '{name}'")
