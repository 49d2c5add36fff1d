"""What Python adds to a run: ratios, printed, held to a bound (--most), or written into a page (--page).

A run's seconds are those of the C++ loop (RunResult.seconds, Trajectory.seconds); the wall clock in Python holds reading the
scene, the arrays and the call besides. Repetitions are interleaved, medians compared."""

import argparse
import statistics
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import lagroid
import numpy as np

STEPS = 100_000
REPETITIONS = 15
BEGIN, END = "<!-- measured: python3 python/bench/overhead.py --page -->", "<!-- end -->"


def scenes() -> dict[str, dict[str, object]]:
    """Steps of different costs."""
    time_of = {"step": 0.01, "steps": STEPS}
    return {
        "pendulum": {
            "system": "pendulum",
            "initial": {"position": [1.0], "momentum": [0.0]},
            "time": time_of,
        },
        "kepler": {"system": "kepler", "initial": {"position": [1, 0], "momentum": [0, 1.2]}, "time": time_of},
        "rigid_body": {
            "system": "rigid_body",
            "parameters": {"inertia": [1.0, 2.0, 3.0]},
            "initial": {"momentum": [1.0, 0.1, 2.0]},
            "time": time_of,
        },
    }


def timed(call: Callable[[], lagroid.RunResult | lagroid.Trajectory]) -> tuple[float, float]:
    """Seconds by the wall, and those that the result says of itself. It is let go when the clock has stopped."""
    start = time.perf_counter()
    result = call()
    assert len(result.momentum if isinstance(result, lagroid.Trajectory) else result["momentum"]) == STEPS + 1
    return time.perf_counter() - start, lagroid.require(result).seconds


def integrated() -> lagroid.Trajectory:
    return lagroid.Kepler(h=0.01).integrator(momentum=[0, 1.2], object=[1, 0]).integrate(STEPS)


def looped(count: int) -> float:
    """Seconds a step, one `advance` and one look at the object at a time."""
    integrator = lagroid.Kepler(h=0.01).integrator(momentum=[0, 1.2], object=[1, 0])
    start = time.perf_counter()
    for _ in range(count):
        integrator.advance()
        integrator.object  # noqa: B018
    return (time.perf_counter() - start) / count


def advanced(count: int) -> float:
    integrator = lagroid.Kepler(h=0.01).integrator(momentum=[0, 1.2], object=[1, 0])
    start = time.perf_counter()
    for _ in range(count):
        integrator.advance()
    return (time.perf_counter() - start) / count


class Pendulum(lagroid.System):
    """As lagroid.Pendulum."""

    groupoid = lagroid.Pair(1)

    def lagrangian(self, q0: Any, q1: Any) -> Any:
        return (q1 - q0) @ (q1 - q0) / (2 * self.h) + self.h * np.cos((q0 + q1)[0] / 2)


class Kepler(lagroid.System):
    """As lagroid.Kepler."""

    groupoid = lagroid.Pair(2)

    def lagrangian(self, q0: Any, q1: Any) -> Any:
        middle = (q0 + q1) / 2
        return (q1 - q0) @ (q1 - q0) / (2 * self.h) + self.h / np.sqrt(middle @ middle)


class SphericalPendulum(lagroid.System):
    """As lagroid.SphericalPendulum."""

    groupoid = lagroid.Pair(3)

    def lagrangian(self, q0: Any, q1: Any) -> Any:
        return (q1 - q0) @ (q1 - q0) / (2 * self.h) - self.h * (q0[2] + q1[2]) / 2

    def object_constraint(self, q: Any) -> Any:
        return np.array([(q @ q - 1) / 2])


class RigidBody(lagroid.System):
    """As lagroid.RigidBody, by Cayley's map."""

    groupoid = lagroid.SO3()
    inertia = np.array([1.0, 2.0, 3.0])

    def lagrangian(self, g: Any) -> Any:
        w = 2 / (1 + np.trace(g)) * np.array([g[2, 1] - g[1, 2], g[0, 2] - g[2, 0], g[1, 0] - g[0, 1]])
        return (w * self.inertia) @ w / (2 * self.h)


def prototypes() -> dict[str, tuple[Any, Any, dict[str, Any]]]:
    """Prototypes, the compiled systems that they are, and where both begin."""
    h = 0.05
    body = lagroid.RigidBody(h=h, inertia=[1, 2, 3], rotation="cayley")
    return {
        "pendulum, 1 degree of freedom": (Pendulum(h=h), lagroid.Pendulum(h=h), {"momentum": [1.0], "object": [0.0]}),
        "Kepler, 2": (Kepler(h=h), lagroid.Kepler(h=h), {"momentum": [0, 1.2], "object": [1.0, 0]}),
        "rigid body, 3": (RigidBody(h=h), body, {"momentum": [1, 0.1, 2]}),
        "spherical pendulum, 3 and a constraint": (
            SphericalPendulum(h=h),
            lagroid.SphericalPendulum(h=h),
            {"momentum": [0, 0.5, 0], "object": [1.0, 0, 0]},
        ),
    }


def integrating(system: Any, begin: dict[str, Any], count: int) -> float:
    """Seconds of the processor for a step of many, recorded: the two differ by thousands, whatever else runs."""
    integrator = system.integrator(**begin)
    start = time.process_time()
    lagroid.require(integrator.integrate(count))
    return (time.process_time() - start) / count


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--most", type=float, help="fail where a run takes longer than this share beyond its C++ loop")
    parser.add_argument("--page", type=Path, help="write the numbers between the marks of this page")
    options = parser.parse_args()
    subjects: dict[str, Callable[[], lagroid.RunResult | lagroid.Trajectory]] = {
        f"`lagroid.run` of {name}": partial(lagroid.run, scene) for name, scene in scenes().items()
    }
    subjects["`Integrator.integrate` of Kepler"] = integrated
    found: dict[str, list[tuple[float, float]]] = {name: [] for name in subjects}
    for _ in range(REPETITIONS):
        for name, call in subjects.items():
            found[name].append(timed(call))
    lines = ["| 1e5 steps, recorded | C++ loop, ms | in Python, ms | overhead |", "|---|---|---|---|"]
    worst = 0.0
    for name, pairs in found.items():
        overhead = statistics.median(wall / own for wall, own in pairs) - 1
        worst = max(worst, overhead)
        wall, own = (statistics.median(column) for column in zip(*pairs))
        lines.append(f"| {name} | {1e3 * own:.1f} | {1e3 * wall:.1f} | {100 * overhead:.1f} % |")
    steps: dict[str, Callable[[], float]] = {
        "`integrate`, a step, ledger and record included": lambda: integrated().seconds / STEPS,
        "`advance()` in a loop": lambda: advanced(20_000),
        "`advance()` and a look at `.object`": lambda: looped(20_000),
    }
    costs: dict[str, list[float]] = {name: [] for name in steps}
    for _ in range(5):
        for name, cost in steps.items():
            costs[name].append(cost())
    lines += ["", "| a step of Kepler's problem | microseconds |", "|---|---|"]
    lines += [f"| {name} | {1e6 * statistics.median(values):.3g} |" for name, values in costs.items()]
    lines += ["", "| a step of | as a prototype, us | compiled, us | times as slow |", "|---|---|---|---|"]
    for name, (prototype, compiled, begin) in prototypes().items():
        both = [(integrating(prototype, begin, 100), integrating(compiled, begin, 20_000)) for _ in range(5)]
        slow, fast = (1e6 * statistics.median(column) for column in zip(*both))
        lines.append(f"| {name} | {slow:.0f} | {fast:.3g} | {float(f'{slow / fast:.2g}'):.0f} |")
    table = "\n".join(lines)
    print(table)
    if options.page:
        before, rest = options.page.read_text().split(BEGIN)
        _, after = rest.split(END)
        options.page.write_text(f"{before}{BEGIN}\n\n{table}\n\n{END}{after}")
    if options.most is not None and worst > options.most:
        print(f"overhead {worst:.3f} is beyond {options.most}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
