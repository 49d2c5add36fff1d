"""Pictures of runs, trajectories and studies by matplotlib. Each returns the figure; none opens a window or needs one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

from ._lagroid import Integrator, LedgerEntry, RunResult, Trajectory
from .prototype import PrototypeTrajectory

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["ledger", "study", "trajectory"]


def _figure(width: float, height: float) -> Figure:
    # Without pyplot: such a figure belongs to no window, and to no thread.
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), constrained_layout=True)
    FigureCanvasAgg(figure)
    return figure


def trajectory(
    run: Union[RunResult, Trajectory, PrototypeTrajectory], columns: Optional[Sequence[str]] = None
) -> Figure:
    """Of a run its panels, as in its plot.svg, or the given columns against time; of a trajectory its objects, momenta and
    quantities, or those of the given names. Raises ValueError where nothing was recorded."""
    if isinstance(run, (Trajectory, PrototypeTrajectory)):
        return _integrated(run, columns)
    if not isinstance(run, RunResult):
        raise TypeError(f"trajectory: draws a RunResult, Trajectory or PrototypeTrajectory, not {type(run).__name__}")
    if len(run.time) < 2:
        raise ValueError("nothing was recorded; run the scene with record=True")
    if columns is not None:
        figure = _figure(7, 4)
        axes = figure.add_subplot()
        for label in columns:
            values = run[label]
            axes.plot(run.time[-len(values) :], values, label=label)
        axes.set_xlabel("t")
        axes.legend()
        return figure
    panels = run.panels
    rows = (len(panels) + 1) // 2
    figure = _figure(10, 3.6 * rows)
    for i, panel in enumerate(panels):
        axes = figure.add_subplot(rows, 2, i + 1)
        x = run[panel.x]
        for label in panel.curves:
            y = run[label]
            axes.plot(x[-len(y) :], y, linewidth=1, label=label)
        axes.set_title(panel.title)
        axes.set_xlabel(panel.x_label)
        axes.set_ylabel(panel.y_label)
        if panel.equal_axes:
            axes.set_aspect("equal", adjustable="datalim")
        if len(panel.curves) > 1:
            axes.legend()
    return figure


def _integrated(trajectory: Union[Trajectory, PrototypeTrajectory], names: Optional[Sequence[str]]) -> Figure:
    """A panel for each series, a curve for each of its numbers."""
    series: dict[str, Any] = dict(trajectory.quantities) if isinstance(trajectory, Trajectory) else {}
    offered = {name: getattr(trajectory, name) for name in ("object", "momentum", "multipliers")} | series
    for name in names or ():
        if name not in offered:
            raise ValueError(f"trajectory: {name} is none of {', '.join(offered)}")
    if len(trajectory.time) < 2:
        raise ValueError("nothing was recorded: the trajectory has no step")
    chosen = names or [name for name in ("object", "momentum", *series) if offered[name].size]
    figure = _figure(7, 2.6 * len(chosen))
    for i, name in enumerate(chosen):
        axes = figure.add_subplot(len(chosen), 1, i + 1)
        rows = offered[name].reshape(len(offered[name]), -1)
        for k, values in enumerate(rows.T):
            axes.plot(trajectory.time[-len(rows) :], values, linewidth=1, label=f"{k + 1}")
        axes.set_ylabel(name)
        if rows.shape[1] > 1:
            axes.legend()
    axes.set_xlabel("t")
    return figure


def ledger(entries: Union[RunResult, Integrator, Sequence[LedgerEntry]]) -> Figure:
    """What was promised and found: the drift of each entry beside its bound, where one is promised."""
    entries = entries.ledger if isinstance(entries, (RunResult, Integrator)) else entries
    watched = [e for e in entries if e.promise != "counted"]
    figure = _figure(8, 1 + 0.5 * max(1, len(watched)))
    axes = figure.add_subplot()
    place = np.arange(len(watched))
    floor = 1e-18
    colours = {"kept": "tab:green", "bounded": "tab:blue", "BROKEN": "tab:red", "growing": "tab:red"}
    axes.barh(
        place,
        [max(e.drift, floor) for e in watched],
        color=[colours.get(e.verdict, "tab:gray") for e in watched],
    )
    axes.scatter([e.bound if e.bound > 0 else np.nan for e in watched], place, marker="|", s=200, color="black")
    axes.set_yticks(place, [f"{e.name}: {e.verdict}" for e in watched])
    axes.invert_yaxis()
    axes.set_xscale("log")
    axes.set_xlabel("largest deviation from the first value; the mark is the bound")
    return figure


def study(found: Mapping[str, Any]) -> Figure:
    """Error at the end against seconds, a curve for each method of `lagroid.study`: drawn strongly where it is the
    cheapest at some error, else pale. An error beyond the motion's own size is no point."""
    figure = _figure(8, 5)
    axes = figure.add_subplot()
    curves: dict[str, list[tuple[float, float]]] = {}
    for run in found["runs"]:
        error = run.get("trajectory")
        if run["status"] == "converged" and error and error <= 1 and run["seconds"]:
            curves.setdefault(run["method"], []).append((run["seconds"], error))
    cheapest = {level["method"] for level in found.get("least_time", {}).get("trajectory", [])}
    colours = [f"C{i}" for i in range(10)]
    markers = "osDv^P*Xhd<>"
    for i, name in enumerate(sorted(curves, key=lambda method: method not in cheapest)):
        strong = name in cheapest
        seconds, errors = zip(*sorted(curves[name]))
        axes.loglog(
            seconds,
            errors,
            color=colours[i % len(colours)],
            marker=markers[(i + i // len(colours)) % len(markers)],
            markersize=5 if strong else 3,
            linewidth=2 if strong else 0.8,
            alpha=1 if strong else 0.35,
            zorder=3 if strong else 2,
            label=name,
        )
    axes.set_xlabel("processor time, s")
    axes.set_ylabel("relative error at the end")
    if curves:
        axes.legend(fontsize="small")
    return figure
