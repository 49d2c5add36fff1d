"""Lagroid in Python: discrete mechanics on Lie groupoids (docs/python.md).

    import lagroid
    run = lagroid.run("examples/kepler.toml", set={"time.steps": 1000})
    run["x"], run["drift energy"], run.ledger
"""

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
    March,
    Minimum,
    Panel,
    Pendulum,
    PlateBall,
    RigidBody,
    RollingBall,
    RollingDisk,
    Run,
    SphericalPendulum,
    Unicycle,
    __version__,
)
from .errors import DataError, Error, Interrupted, OutputError, ProgramError, SceneError, SolveError
from .groupoids import SE2, SE3, SO3, Groupoid, MatrixGroup, Pairs
from .learning import LearnedHamiltonian, Measures, Trajectories, learn, trajectories
from .optimisation import Manifold, Optimum, Product, Sphere, Stiefel, minimise, optimize
from .prototype import DiscreteLagrangian, PrototypeIntegrator, PrototypeMarch
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
    "March",
    "MatrixGroup",
    "Measures",
    "Method",
    "Minimum",
    "Optimum",
    "OutputError",
    "Pairs",
    "Panel",
    "Pendulum",
    "PlateBall",
    "Product",
    "ProgramError",
    "PrototypeIntegrator",
    "PrototypeMarch",
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
    "Stiefel",
    "Sweep",
    "Trajectories",
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
