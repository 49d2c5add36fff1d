"""What Python adds to a run: prints ratios, and holds them to a bound with --most, or writes them into a page with --page.

A run's seconds are those of the C++ loop (Run.seconds, March.seconds); the wall clock in Python holds reading the scene,
the arrays and the call besides. Repetitions are interleaved, medians compared."""

import argparse
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path

import lagroid

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


def timed(call: Callable[[], float]) -> tuple[float, float]:
    """Seconds by the wall, and those that the call says of itself."""
    start = time.perf_counter()
    own = call()
    return time.perf_counter() - start, own


def run_seconds(scene: dict[str, object]) -> float:
    run = lagroid.require(lagroid.run(scene))
    assert len(run["momentum"]) == STEPS + 1
    return run.seconds


def marched(ledger: bool) -> float:
    integrator = lagroid.Kepler(h=0.01).integrator([0, 1.2], [1, 0], ledger=ledger)
    return lagroid.require(integrator.march(STEPS)).seconds


def looped(count: int) -> float:
    """Seconds a step, one `advance` and one look at the object at a time."""
    integrator = lagroid.Kepler(h=0.01).integrator([0, 1.2], [1, 0])
    start = time.perf_counter()
    for _ in range(count):
        integrator.advance()
        integrator.object  # noqa: B018
    return (time.perf_counter() - start) / count


def advanced(count: int) -> float:
    integrator = lagroid.Kepler(h=0.01).integrator([0, 1.2], [1, 0])
    start = time.perf_counter()
    for _ in range(count):
        integrator.advance()
    return (time.perf_counter() - start) / count


class Pendulum(lagroid.DiscreteLagrangian):
    """The prototype whose step is timed."""

    groupoid = lagroid.Pairs(1)

    def lagrangian(self, q0, q1):  # type: ignore[no-untyped-def]
        return ((q1 - q0) @ (q1 - q0)) / (2 * self.h) + self.h * (1 - ((q0 + q1)[0] / 2) ** 2 / 2)


def prototyped(count: int) -> float:
    integrator = Pendulum(h=0.05).integrator([0.0], [1.0])
    start = time.perf_counter()
    integrator.march(count)
    return (time.perf_counter() - start) / count


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--most", type=float, help="fail where a run takes longer than this share beyond its C++ loop")
    parser.add_argument("--page", type=Path, help="write the numbers between the marks of this page")
    options = parser.parse_args()
    subjects: dict[str, Callable[[], float]] = {
        f"`lagroid.run` of {name}": (lambda scene=scene: run_seconds(scene)) for name, scene in scenes().items()  # type: ignore[misc]
    }
    subjects["`Integrator.march` of Kepler"] = lambda: marched(True)
    found: dict[str, list[tuple[float, float]]] = {name: [] for name in subjects}
    for _ in range(REPETITIONS):
        for name, call in subjects.items():
            found[name].append(timed(call))
    lines = [f"| 1e5 steps, recorded | C++ loop, ms | in Python, ms | overhead |", "|---|---|---|---|"]
    worst = 0.0
    for name, pairs in found.items():
        overhead = statistics.median(wall / own for wall, own in pairs) - 1
        worst = max(worst, overhead)
        wall, own = (statistics.median(column) for column in zip(*pairs))
        lines.append(f"| {name} | {1e3 * own:.1f} | {1e3 * wall:.1f} | {100 * overhead:.1f} % |")
    steps = {
        "`march`, a step, ledger and record included": lambda: marched(True) / STEPS,
        "`advance()` in a loop": lambda: advanced(20_000),
        "`advance()` and a look at `.object`": lambda: looped(20_000),
        "a step of a prototype in Python (one degree of freedom)": lambda: prototyped(200),
    }
    costs: dict[str, list[float]] = {name: [] for name in steps}
    for _ in range(5):
        for name, call in steps.items():
            costs[name].append(call())
    lines += ["", "| a step of Kepler's problem, where nothing else is said | microseconds |", "|---|---|"]
    lines += [f"| {name} | {1e6 * statistics.median(values):.3g} |" for name, values in costs.items()]
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
