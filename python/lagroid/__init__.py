"""Lagroid in Python: discrete mechanics on Lie groupoids (docs/python.md).

    import lagroid
    run = lagroid.run("examples/kepler.toml", set={"time.steps": 1000})
    run["x"], run["drift energy"], run.ledger
"""

from . import plot
from ._lagroid import (
    BoundaryPath,
    Endpoint,
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
    Run,
    Series,
    SphericalPendulum,
    __version__,
)
from .errors import DataError, Error, Interrupted, OutputError, ProgramError, SceneError, SolveError
from .learning import LearnedHamiltonian, Measures, Trajectories, learn, trajectories
from .optimisation import Manifold, Optimum, Product, Sphere, Stiefel, minimise, optimize
from .prototype import (
    SE2,
    SE3,
    SO3,
    DiscreteLagrangian,
    Groupoid,
    MatrixGroup,
    Pairs,
    PrototypeIntegrator,
    PrototypeMarch,
)
from .scenes import require, resume, run, scene_text, systems
from .studies import Method, check, methods, study

__all__ = [name for name in dir() if not name.startswith("_") and name not in {"scenes", "studies", "errors"}]
