"""What is compiled."""

import os
from collections.abc import Callable, Sequence
from typing import Any, Literal, Optional, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

_Array = NDArray[np.float64]
_Path = str | os.PathLike[str]

__version__: str

def listing() -> str: ...
def read_hdf5(file: _Path, dataset: str) -> _Array: ...

# Scenes and their runs.

@final
class Scene:
    @staticmethod
    def file(file: _Path, overrides: Sequence[str]) -> Scene: ...
    @staticmethod
    def text(text: str, name: str, overrides: Sequence[str]) -> Scene: ...
    @property
    def name(self) -> str: ...
    def toml(self) -> str: ...

@final
class EventNode:
    def __getitem__(self, label: str) -> float: ...

@final
class Endpoint:
    @property
    def time(self) -> float: ...
    @property
    def position(self) -> _Array: ...
    @property
    def attitude(self) -> Optional[list[float]]: ...
    @property
    def body_attitude(self) -> Optional[list[float]]: ...
    @property
    def momentum(self) -> _Array: ...

@final
class LedgerEntry:
    @property
    def name(self) -> str: ...
    @property
    def promise(self) -> str: ...
    @property
    def initial(self) -> _Array: ...
    @property
    def final(self) -> _Array: ...
    @property
    def drift(self) -> float: ...
    @property
    def relative_drift(self) -> float: ...
    @property
    def bound(self) -> float: ...
    @property
    def verdict(self) -> str: ...
    @property
    def reason(self) -> str: ...
    @property
    def broken(self) -> bool: ...

@final
class StationaryPath:
    @property
    def cost(self) -> float: ...
    @property
    def starts(self) -> int: ...
    @property
    def momentum(self) -> _Array: ...
    @property
    def is_minimum(self) -> bool: ...
    @property
    def isolated(self) -> bool: ...
    @property
    def normal(self) -> bool: ...
    @property
    def negative_directions(self) -> int: ...

@final
class Columns:
    @property
    def name(self) -> str: ...
    @property
    def components(self) -> list[str]: ...
    @property
    def unit(self) -> str: ...
    @property
    def meaning(self) -> str: ...
    @property
    def on_arrows(self) -> bool: ...
    @property
    def values(self) -> _Array: ...

@final
class Panel:
    @property
    def title(self) -> str: ...
    @property
    def x_label(self) -> str: ...
    @property
    def y_label(self) -> str: ...
    @property
    def x(self) -> str: ...
    @property
    def curves(self) -> list[str]: ...
    @property
    def equal_axes(self) -> bool: ...

@final
class RunResult:
    @property
    def system(self) -> str: ...
    @property
    def method(self) -> str: ...
    @property
    def status(self) -> str: ...
    @property
    def message(self) -> str: ...
    @property
    def steps(self) -> int: ...
    @property
    def steps_asked(self) -> int: ...
    @property
    def seconds(self) -> float: ...
    @property
    def iterations(self) -> int: ...
    @property
    def cost(self) -> Optional[float]: ...
    @property
    def residual(self) -> Optional[float]: ...
    @property
    def initial(self) -> Endpoint: ...
    @property
    def final(self) -> Endpoint: ...
    @property
    def first_multipliers(self) -> _Array: ...
    @property
    def last_multipliers(self) -> _Array: ...
    @property
    def starts(self) -> int: ...
    @property
    def minima(self) -> list[StationaryPath]: ...
    @property
    def stationary_paths(self) -> list[StationaryPath]: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def ledger(self) -> list[LedgerEntry]: ...
    @property
    def mean_iterations(self) -> float: ...
    @property
    def most_iterations(self) -> int: ...
    @property
    def time(self) -> _Array: ...
    @property
    def series(self) -> list[Columns]: ...
    @property
    def events(self) -> list[dict[str, Any]]: ...
    @property
    def conventions(self) -> dict[str, str]: ...
    @property
    def panels(self) -> list[Panel]: ...
    @property
    def columns(self) -> list[str]: ...
    def __getitem__(self, label: str) -> _Array: ...
    def __contains__(self, label: str) -> bool: ...
    @property
    def converged(self) -> bool: ...
    @property
    def interrupted(self) -> bool: ...
    def text(self) -> str: ...
    def json(self) -> str: ...
    def write(self, folder: _Path) -> list[os.PathLike[str]]: ...

def run(
    scene: Scene, record: bool, folder: Optional[_Path], events: list[dict[str, Any]]
) -> RunResult: ...
def resume(folder: _Path, steps: Optional[int], other_build: bool) -> RunResult: ...

# Integrators of systems.

class Motion: ...

@final
class Trajectory:
    @property
    def status(self) -> str: ...
    @property
    def message(self) -> str: ...
    @property
    def steps(self) -> int: ...
    @property
    def seconds(self) -> float: ...
    @property
    def converged(self) -> bool: ...
    @property
    def time(self) -> _Array: ...
    @property
    def quantities(self) -> dict[str, _Array]: ...
    @property
    def object(self) -> _Array: ...
    @property
    def momentum(self) -> _Array: ...
    @property
    def configuration(self) -> _Array: ...
    @property
    def arrow(self) -> _Array: ...
    @property
    def multipliers(self) -> _Array: ...
    @property
    def step_size(self) -> _Array: ...

@final
class Integrator:
    def __init__(
        self, motion: Motion, ledger: bool = True, origin: Optional[tuple[Any, dict[str, Any]]] = None
    ) -> None: ...
    def advance(self) -> None: ...
    def integrate(self, steps: int, every: int = 1) -> Trajectory: ...
    def march(self, steps: int, every: int = 1) -> Trajectory: ...
    @property
    def index(self) -> int: ...
    @property
    def time(self) -> float: ...
    @property
    def state(self) -> tuple[_Array, _Array]: ...
    @property
    def method(self) -> str: ...
    @property
    def ledger(self) -> list[LedgerEntry]: ...
    def quantity(self, name: str) -> _Array: ...
    @property
    def object(self) -> _Array: ...
    @property
    def momentum(self) -> _Array: ...
    @property
    def configuration(self) -> _Array: ...
    @property
    def arrow(self) -> _Array: ...
    @property
    def multipliers(self) -> _Array: ...
    @property
    def step_size(self) -> _Array: ...

@final
class BoundarySolution:
    @property
    def cost(self) -> float: ...
    @property
    def starts(self) -> int: ...
    @property
    def is_minimum(self) -> bool: ...
    @property
    def isolated(self) -> bool: ...
    @property
    def normal(self) -> bool: ...
    @property
    def negative_directions(self) -> int: ...
    @property
    def object(self) -> _Array: ...
    @property
    def momentum(self) -> _Array: ...
    @property
    def arrow(self) -> _Array: ...
    @property
    def multipliers(self) -> _Array: ...

class _System:
    h: float
    @property
    def groupoid(self) -> str: ...
    def integrator(
        self,
        *,
        momentum: ArrayLike,
        object: Optional[ArrayLike] = None,
        configuration: Optional[ArrayLike] = None,
        mode: str = "fixed",
        method: str = "variational",
        order: Optional[int] = None,
        composition: Optional[str] = None,
        without_root: str = "stop",
        max_iterations: int = 0,
        tolerance: float = 0.0,
        ledger: bool = True,
    ) -> Integrator: ...

class _WithBoundary(_System):
    def boundary(
        self, arrow: ArrayLike, steps: int, *, method: str = "newton", starts: int = 40, seed: int = 1
    ) -> list[BoundarySolution]: ...

# Systems: written by ./lagroid pages stubs

__all__ = [
    "PlateBall",
    "Unicycle",
    "AttitudeControl",
    "RigidBody",
    "HeavyTop",
    "Pendulum",
    "Kepler",
    "SphericalPendulum",
    "Gyrostat",
    "RollingBall",
    "RollingDisk",
    "ChaplyginSleigh",
    "DampedPendulum",
    "DrivenPendulum",
    "DrivenBody",
]

class PlateBall(_WithBoundary):
    def __init__(
        self,
        *,
        h: float = ...,
        radius: float = ...,  # of the ball, m
        plate_rate: float = ...,  # angular velocity of the plate, rad/s
        spin: float = ...,  # prescribed rate about the vertical, rad/s
        rotation: Literal["trace", "exp", "cayley"] = ...,  # form of the constraints
    ) -> None: ...
    radius: float
    plate_rate: float
    spin: float
    rotation: Literal["trace", "exp", "cayley"]
    @staticmethod
    def arrow(start: ArrayLike, end: ArrayLike, turn: ArrayLike) -> _Array: ...

class Unicycle(_WithBoundary):
    def __init__(
        self,
        *,
        h: float = ...,
        speed: float = ...,  # forward speed, m/s
        map: Literal["exp", "cayley"] = ...,  # how a motion becomes a velocity
    ) -> None: ...
    speed: float
    map: Literal["exp", "cayley"]

class AttitudeControl(_WithBoundary):
    def __init__(
        self,
        *,
        h: float = ...,
        weights: ArrayLike = ...,  # three weights of the cost w.W w / 2
        forbidden: ArrayLike = ...,  # the forbidden axis in the body
        rotation: Literal["exp", "cayley"] = ...,  # how a rotation becomes an angular velocity
    ) -> None: ...
    @property
    def weights(self) -> _Array: ...
    @weights.setter
    def weights(self, value: ArrayLike) -> None: ...
    @property
    def forbidden(self) -> _Array: ...
    @forbidden.setter
    def forbidden(self, value: ArrayLike) -> None: ...
    rotation: Literal["exp", "cayley"]

class RigidBody(_WithBoundary):
    def __init__(
        self,
        *,
        h: float = ...,
        inertia: ArrayLike = ...,  # principal moments, kg m^2
        rotation: Literal["exp", "cayley"] = ...,  # how a rotation becomes an angular velocity
    ) -> None: ...
    @property
    def inertia(self) -> _Array: ...
    @inertia.setter
    def inertia(self, value: ArrayLike) -> None: ...
    rotation: Literal["exp", "cayley"]

class HeavyTop(_WithBoundary):
    def __init__(
        self,
        *,
        h: float = ...,
        inertia: ArrayLike = ...,  # principal moments, kg m^2
        weight: ArrayLike = ...,  # weight times the vector to the centre of mass, N m
        rotation: Literal["exp", "cayley"] = ...,  # how a rotation becomes an angular velocity
    ) -> None: ...
    @property
    def inertia(self) -> _Array: ...
    @inertia.setter
    def inertia(self, value: ArrayLike) -> None: ...
    @property
    def weight(self) -> _Array: ...
    @weight.setter
    def weight(self, value: ArrayLike) -> None: ...
    rotation: Literal["exp", "cayley"]
    @staticmethod
    def arrow(attitude: ArrayLike) -> _Array: ...

class Pendulum(_WithBoundary):
    def __init__(
        self,
        *,
        h: float = ...,
        mass: float = ...,  # of the bob, kg
        length: float = ...,  # of the rod, m
        gravity: float = ...,  # acceleration, m/s^2
        quadrature: Literal["midpoint", "trapezoid"] = ...,  # of the potential over a step
    ) -> None: ...
    mass: float
    length: float
    gravity: float
    quadrature: Literal["midpoint", "trapezoid"]

class Kepler(_WithBoundary):
    def __init__(
        self,
        *,
        h: float = ...,
        strength: float = ...,  # of the attraction, m^3/s^2
        quadrature: Literal["midpoint", "trapezoid"] = ...,  # of the potential over a step
    ) -> None: ...
    strength: float
    quadrature: Literal["midpoint", "trapezoid"]

class SphericalPendulum(_WithBoundary):
    def __init__(
        self,
        *,
        h: float = ...,
        mass: float = ...,  # of the bob, kg
        length: float = ...,  # of the rod, m
        gravity: float = ...,  # acceleration, m/s^2
        quadrature: Literal["midpoint", "trapezoid"] = ...,  # of the potential over a step
    ) -> None: ...
    mass: float
    length: float
    gravity: float
    quadrature: Literal["midpoint", "trapezoid"]

class Gyrostat(_WithBoundary):
    def __init__(
        self,
        *,
        h: float = ...,
        inertia: ArrayLike = ...,  # principal moments, kg m^2
        rotors: ArrayLike = ...,  # moments of the three rotors about their axes, kg m^2
        rotation: Literal["exp", "cayley"] = ...,  # how a rotation becomes an angular velocity
    ) -> None: ...
    @property
    def inertia(self) -> _Array: ...
    @inertia.setter
    def inertia(self, value: ArrayLike) -> None: ...
    @property
    def rotors(self) -> _Array: ...
    @rotors.setter
    def rotors(self, value: ArrayLike) -> None: ...
    rotation: Literal["exp", "cayley"]

class RollingBall(_System):
    def __init__(
        self,
        *,
        h: float = ...,
        mass: float = ...,  # of the ball, kg
        radius: float = ...,  # of the ball, m
        inertia_factor: float = ...,  # moment of inertia over mass times radius squared
        plate_rate: float = ...,  # angular velocity of the plate, rad/s
    ) -> None: ...
    mass: float
    radius: float
    inertia_factor: float
    plate_rate: float

class RollingDisk(_System):
    def __init__(
        self,
        *,
        h: float = ...,
        mass: float = ...,  # of the disk, kg
        radius: float = ...,  # of the disk, m
        rolling_inertia: float = ...,  # about its axis, kg m^2
        turning_inertia: float = ...,  # about the vertical, kg m^2
    ) -> None: ...
    mass: float
    radius: float
    rolling_inertia: float
    turning_inertia: float

class ChaplyginSleigh(_System):
    def __init__(
        self,
        *,
        h: float = ...,
        mass: float = ...,  # of the body, kg
        inertia: float = ...,  # about its centre of mass, kg m^2
        offset: float = ...,  # from the blade ahead to the centre of mass, m
        map: Literal["exp", "cayley"] = ...,  # how a motion becomes a velocity
    ) -> None: ...
    mass: float
    inertia: float
    offset: float
    map: Literal["exp", "cayley"]

class DampedPendulum(_System):
    def __init__(
        self,
        *,
        h: float = ...,
        mass: float = ...,  # of the bob, kg
        length: float = ...,  # of the rod, m
        gravity: float = ...,  # acceleration, m/s^2
        quadrature: Literal["midpoint", "trapezoid"] = ...,  # of the potential over a step
        damping: float = ...,  # torque over angular velocity, N m s
    ) -> None: ...
    mass: float
    length: float
    gravity: float
    quadrature: Literal["midpoint", "trapezoid"]
    damping: float

class DrivenPendulum(_System):
    def __init__(
        self,
        *,
        h: float = ...,
        mass: float = ...,  # of the bob, kg
        length: float = ...,  # of the rod, m
        gravity: float = ...,  # acceleration, m/s^2
        frequency: float = ...,  # of the drive, rad/s
        torque: float = ...,  # amplitude of the torque, N m
        amplitude: float = ...,  # of the support's motion up and down, m
    ) -> None: ...
    mass: float
    length: float
    gravity: float
    frequency: float
    torque: float
    amplitude: float

class DrivenBody(_System):
    def __init__(
        self,
        *,
        h: float = ...,
        inertia: ArrayLike = ...,  # principal moments, kg m^2
        rotation: Literal["exp", "cayley"] = ...,  # how a rotation becomes an angular velocity
        torque: ArrayLike = ...,  # of a thruster, fixed in the body, N m
        drag: float = ...,  # torque over angular velocity, N m s
    ) -> None: ...
    @property
    def inertia(self) -> _Array: ...
    @inertia.setter
    def inertia(self, value: ArrayLike) -> None: ...
    rotation: Literal["exp", "cayley"]
    @property
    def torque(self) -> _Array: ...
    @torque.setter
    def torque(self, value: ArrayLike) -> None: ...
    drag: float

# End of what is written.

# Studies.

def study(
    scene: Scene,
    methods: str,
    steps: Sequence[float],
    target: float,
    longest: float,
    reference_time: float,
    budget: float,
    repetitions: int,
    folder: Optional[_Path],
) -> str: ...
def methods(scene: Scene) -> list[tuple[str, int, str]]: ...

# Optimisation.

@final
class Manifold:
    @property
    def name(self) -> str: ...
    @property
    def size(self) -> int: ...
    @property
    def dimension(self) -> int: ...
    def random(self, seed: int = 1) -> _Array: ...

def Sphere(n: int) -> Manifold: ...
def Stiefel(n: int, m: int) -> Manifold: ...
def ProductManifold(factors: Sequence[Manifold]) -> Manifold: ...

@final
class ControlResult:
    @property
    def problem(self) -> str: ...
    @property
    def groupoid(self) -> str: ...
    @property
    def state_names(self) -> list[str]: ...
    @property
    def control_names(self) -> list[str]: ...
    @property
    def status(self) -> str: ...
    @property
    def message(self) -> str: ...
    @property
    def converged(self) -> bool: ...
    @property
    def cost(self) -> float: ...
    @property
    def duration(self) -> float: ...
    @property
    def is_strict_minimum(self) -> bool: ...
    @property
    def iterations(self) -> int: ...
    @property
    def costs(self) -> _Array: ...
    @property
    def times(self) -> _Array: ...
    @property
    def states(self) -> _Array: ...
    @property
    def controls(self) -> _Array: ...
    @property
    def costates(self) -> _Array: ...
    @property
    def summary(self) -> str: ...

def control(scene: Scene, folder: Optional[_Path]) -> ControlResult: ...

@final
class Optimum:
    @property
    def x(self) -> _Array: ...
    @property
    def value(self) -> float: ...
    @property
    def gradient(self) -> float: ...
    @property
    def residual(self) -> float: ...
    @property
    def status(self) -> str: ...
    @property
    def message(self) -> str: ...
    @property
    def converged(self) -> bool: ...
    @property
    def iterations(self) -> int: ...
    @property
    def seconds(self) -> float: ...
    @property
    def evaluations(self) -> tuple[int, int, int]: ...
    @property
    def values(self) -> _Array: ...
    @property
    def gradients(self) -> _Array: ...
    @property
    def summary(self) -> str: ...

def minimise(
    manifold: Manifold,
    fun: Callable[[_Array], tuple[float, Any]],
    start: Optional[ArrayLike],
    method: str,
    hessian: Optional[Callable[[_Array, _Array], Any]],
    seed: int,
    gradient: float,
    relative_gradient: float,
    iterations: int,
    seconds: float,
    history: bool,
) -> Optimum: ...
def optimise(scene: Scene, history: bool, folder: Optional[_Path]) -> Optimum: ...

# Learning.

@final
class Trajectories:
    def __init__(self, states: ArrayLike, time: ArrayLike, *, noise: float = 0.0) -> None: ...
    @staticmethod
    def read(file: _Path, *, noise: float = 0.0) -> Trajectories: ...
    @staticmethod
    def chain(
        masses: ArrayLike,
        lengths: ArrayLike,
        *,
        gravity: float = 1.0,
        count: int = 500,
        points: int = 5,
        duration: float = 0.1,
        noise: float = 0.0,
        seed: int = 0,
    ) -> Trajectories: ...
    @property
    def bodies(self) -> int: ...
    @property
    def points(self) -> int: ...
    @property
    def interval(self) -> float: ...
    @property
    def states(self) -> _Array: ...
    def __len__(self) -> int: ...

@final
class Measures:
    @property
    def mse(self) -> float: ...
    @property
    def times(self) -> list[float]: ...
    @property
    def rms(self) -> list[float]: ...
    @property
    def energy_largest(self) -> float: ...
    @property
    def energy_rms(self) -> float: ...
    @property
    def momentum_learned(self) -> float: ...
    @property
    def momentum_data(self) -> float: ...
    @property
    def lost(self) -> int: ...

@final
class LearnedHamiltonian:
    @staticmethod
    def read(file: _Path) -> LearnedHamiltonian: ...
    def write(self, file: _Path) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def bodies(self) -> int: ...
    @property
    def parameters(self) -> _Array: ...
    @property
    def mass(self) -> _Array: ...
    @property
    def status(self) -> str: ...
    @property
    def message(self) -> str: ...
    @property
    def usable(self) -> bool: ...
    @property
    def mse(self) -> float: ...
    @property
    def validation(self) -> float: ...
    @property
    def mass_determined(self) -> bool: ...
    @property
    def iterations(self) -> int: ...
    @property
    def seconds(self) -> float: ...
    @property
    def history(self) -> _Array: ...
    def energy(self, z: ArrayLike) -> float: ...
    def field(self, z: ArrayLike) -> _Array: ...
    def follow(self, start: ArrayLike, times: Sequence[float], *, tolerance: float = 1e-12) -> _Array: ...
    def measure(self, data: Trajectories, *, tolerance: float = 1e-12) -> Measures: ...

def learn(
    data: Trajectories,
    model: str,
    begin: Optional[LearnedHamiltonian],
    integrator: str,
    substeps: int,
    validation: float,
    starts: int,
    iterations: int,
    seed: int,
    enough: float,
    seconds: float,
) -> LearnedHamiltonian: ...
