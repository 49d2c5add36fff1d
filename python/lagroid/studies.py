"""What accuracy costs a scene, the laws asked of its system, and how its run depends on where it starts."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, Optional

import numpy as np
from numpy.typing import NDArray

from . import _lagroid
from ._lagroid import RunResult
from .errors import SolveError
from .programs import output_of, program
from .scenes import SceneLike, is_file, made, settings

__all__ = ["GradientTable", "Method", "Uncertainty", "check", "fit", "gradient", "methods", "study", "uncertainty"]


class Method(NamedTuple):
    """A way to integrate a scene: its name, its order, and what [time] holds for it."""

    name: str
    order: int
    time: str


def methods(scene: SceneLike, *, set: Optional[Mapping[str, Any]] = None) -> list[Method]:
    """The methods that apply to a scene."""
    return [Method(*each) for each in _lagroid.methods(made(scene, set))]


def study(
    scene: SceneLike,
    *,
    set: Optional[Mapping[str, Any]] = None,
    methods: Sequence[str] = (),
    steps: Sequence[float] = (),
    target: float = 1e-6,
    longest: float = 0.25,
    reference_time: float = 20.0,
    budget: float = 60.0,
    repetitions: int = 5,
    out: Optional[str | os.PathLike[str]] = None,
) -> dict[str, Any]:
    """Error against time and evaluations by all methods whose names match (["splitting*"]; all by default), as
    `lagroid study --json` tells it (docs/which_method.md).

    `steps`: sizes in s, or found: halved until errors are those of round-off or a run lasts `longest` s. `target`: the
    error for which a method is recommended. `budget`: seconds of wall clock that all of it may take, spent first on the
    methods that are the cheapest, or near them; "not_measured" tells what was left out. `reference_time`: seconds that
    the reference may take, of a third of the budget. `out`: a folder for its page and figures. Raises KeyboardInterrupt
    after Ctrl-C."""
    patterns = [methods] if isinstance(methods, str) else methods
    found: dict[str, Any] = json.loads(
        _lagroid.study(
            made(scene, set), ",".join(patterns), list(steps), target, longest, reference_time, budget, repetitions, out
        )
    )
    return found


def check(
    scene: SceneLike, *, set: Optional[Mapping[str, Any]] = None, arguments: Sequence[str] = ()
) -> dict[str, Any]:
    """Asks the scene's system every law, from groupoid axioms to Noether, by the program lagroid-check, in which the
    laws are compiled: the certificate that it prints with --json. `arguments` go to it as they are. Raises ProgramError
    where it is missing, SceneError where it refuses the scene."""
    return told_by("check", scene, set, arguments)


class GradientTable(NamedTuple):
    """Exact derivatives of a run: a row for each function, a column for each of what they are taken by."""

    of: list[str]
    by: list[str]
    values: NDArray[np.float64]
    derivatives: NDArray[np.float64]
    growth: float
    digits_left: float
    differences: Optional[NDArray[np.float64]]
    digits_agreed: Optional[float]
    notes: list[str]
    contradicted: Sequence[str] = ()  # by differences, as "final.q by parameters.length"
    steps_solved: int = 0  # in all, those computed again on the way back too
    states_kept: int = 0  # at most, at a time, on the way back


def gradient(
    scene: SceneLike,
    *,
    of: str | Sequence[str] = ("final",),
    wrt: str | Sequence[str] = ("initial", "parameters"),
    columns: Optional[Mapping[str, str]] = None,
    set: Optional[Mapping[str, Any]] = None,
    check: bool = False,
    states: int = 0,
) -> GradientTable:
    """The derivatives of a scene's run by its start and its parameters, exact, by the program lagroid-gradient
    (docs/gradients.md): `of` what, as "final.position", "node.10.px", "integral.x" or, through the scene's events,
    "event.floor.1.t", and `wrt` what, as "initial.momentum" or "parameters.strength". `columns`: more columns of the run,
    as {"w1": "M1 / parameters.inertia.0"}. `check` compares with extrapolated differences of runs, and names
    what they contradict. With `states` the way is back, and keeps at most so many of them. Raises
    ProgramError where the program is missing, SceneError where it refuses, SolveError where a step of the run fails."""
    arguments = ["--of", listed(of), "--wrt", listed(wrt), *repeated("--column", columns)]
    arguments += ["--check"] if check else []
    arguments += ["--states", str(states)] if states else []
    found = told_by("gradient", scene, set, arguments)
    if found.get("status") == "failed":
        raise SolveError(found["message"])
    differences = found.get("differences")
    return GradientTable(
        found["of"],
        found["by"],
        np.array(found["values"]),
        np.array(found["derivatives"]),
        found["growth"],
        found["digits_left"],
        None if differences is None else np.array(differences),
        found.get("digits_agreed"),
        found.get("notes", []),
        found.get("contradicted", []),
        found.get("steps_solved", 0),
        found.get("states_kept", 0),
    )


def gradient_of_run(run: RunResult, **asked: Any) -> GradientTable:
    """`RunResult.gradient`: of the scene that was run, as it was set; a file is read again."""
    if not hasattr(run, "_of"):
        raise ValueError(
            "a run that was resumed, or has events of Python's, does not hold its scene: ask lagroid.gradient(scene)"
        )
    scene, given = run._of
    return gradient(scene, set=given, **asked)


class Uncertainty(NamedTuple):
    """What errors of the start and of parameters become: a row for each function, a column for each error."""

    of: list[str]
    by: list[str]
    values: NDArray[np.float64]
    deviations: NDArray[np.float64]
    derivatives: NDArray[np.float64]
    covariance: NDArray[np.float64]
    drawn_mean: Optional[NDArray[np.float64]]
    drawn_covariance: Optional[NDArray[np.float64]]


def uncertainty(
    scene: SceneLike,
    deviations: Optional[Mapping[str, float]] = None,
    *,
    fitted: Optional[Mapping[str, Any]] = None,
    of: str | Sequence[str] = ("final",),
    columns: Optional[Mapping[str, str]] = None,
    set: Optional[Mapping[str, Any]] = None,
    draws: int = 0,
    seed: int = 1,
) -> Uncertainty:
    """The covariance of functions of a scene's run where its start and its parameters have normal errors, independent
    ones of `deviations` = {"initial.momentum": 0.01, "parameters.length": 0.02}, or those of what `fit` has `fitted`, from
    there; by exact derivatives in the linear approximation, and with `draws` that of so many runs from starts drawn at
    random (docs/gradients.md). Raises what `gradient` raises, and ValueError unless one of both is given."""
    if (deviations is None) == (fitted is None):
        raise ValueError("give deviations, or what was fitted")
    arguments = ["--of", listed(of), *repeated("--column", columns)]
    drawn_at_random = ["--draws", str(draws), "--seed", str(seed)] if draws else []
    with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
        if deviations is not None:
            arguments += ["--deviations", ",".join(f"{name}={size!r}" for name, size in deviations.items())]
        else:
            json.dump(fitted, file)
            file.flush()
            arguments += ["--covariance", file.name]
        found = told_by("gradient", scene, set, arguments + drawn_at_random)
    if found.get("status") == "failed":
        raise SolveError(found["message"])
    drawn = found.get("draws")
    return Uncertainty(
        found["of"],
        found["by"],
        np.array(found["values"]),
        np.array(found["deviations"]),
        np.array(found["derivatives"]),
        np.array(found["covariance"]),
        None if drawn is None else np.array(drawn["mean"]),
        None if drawn is None else np.array(drawn["covariance"]),
    )


def fit(
    scene: SceneLike,
    data: str | os.PathLike[str] | Sequence[str | os.PathLike[str]],
    wrt: str | Sequence[str],
    *,
    of: str | Sequence[str] = (),
    columns: Optional[Mapping[str, str]] = None,
    combinations: Optional[Mapping[str, str]] = None,
    sigma: Optional[Mapping[str, float]] = None,
    bounds: Optional[Mapping[str, tuple[float, float]]] = None,
    huber: float = 0.0,
    starts: int = 1,
    spread: float = 0.3,
    seed: int = 1,
    set: Optional[Mapping[str, Any]] = None,
) -> dict[str, Any]:
    """Parameters and starts of a scene from measured columns, as `lagroid fit --json` tells them (docs/fit.md):
    "unknowns", "covariance", "undetermined" and more.

    `data`: a CSV or HDF5 file, or one for each run, with `t` and columns of the run; empty fields and NaN are gaps. `wrt`: what
    is fitted, as "initial.momentum" or "parameters.length". `of`: the columns that are used, all by default. `columns`:
    more columns of the run, as {"w1": "M1 / parameters.inertia.0"}, and `combinations` functions of unknowns that are
    to be told, as {"ratio": "parameters.inertia.1 / parameters.inertia.0"}. `sigma`: deviations of their errors, 1 by default. `bounds`: of what is fitted. `huber`: beyond so many sigma a residual
    weighs by its size. `starts`: guesses, others than the scene's being drawn around it by `spread`. Raises what
    `gradient` raises, and SolveError where no run comes to its end."""
    files = [os.fspath(each) for each in ([data] if isinstance(data, (str, os.PathLike)) else data)]
    arguments = [*files, "--wrt", listed(wrt), *repeated("--column", columns), *repeated("--combination", combinations)]
    if of:
        arguments += ["--of", listed(of)]
    if sigma:
        arguments += ["--sigma", ",".join(f"{name}={size!r}" for name, size in sigma.items())]
    if bounds:
        arguments += ["--bounds", ",".join(f"{name}={low!r}:{high!r}" for name, (low, high) in bounds.items())]
    if huber:
        arguments += ["--huber", repr(huber)]
    if starts > 1:
        arguments += ["--starts", str(starts), "--spread", repr(spread), "--seed", str(seed)]
    found = told_by("gradient", scene, set, arguments, word="fit")
    if found["status"] == "failed":
        raise SolveError(found["message"])
    return found


def listed(names: str | Sequence[str]) -> str:
    """One name, or several, as the command line takes them. Raises TypeError where one is no text."""
    words = [names] if isinstance(names, str) else list(names)
    for each in words:
        if not isinstance(each, str):
            raise TypeError(f"of and wrt are names, and {each!r} is none: give text, as \"final.position\"")
    return ",".join(words)


def repeated(option: str, texts: Optional[Mapping[str, str]]) -> list[str]:
    """An option for each of some texts with names."""
    return [word for name, text in (texts or {}).items() for word in (option, f"{name}={text}")]


def told_by(
    command: str,
    scene: SceneLike,
    set: Optional[Mapping[str, Any]],
    arguments: Sequence[str],
    word: Optional[str] = None,
) -> dict[str, Any]:
    """What the program of a command that stands beside lagroid prints of a scene with --json, after a word."""
    asked = made(scene, set)
    text = asked.toml()  # what is mistaken in it is told here
    path = program(f"lagroid-{command}", f"LAGROID_{command.upper()}", f"lagroid_{command}")
    with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
        words = [path] if word is None else [path, word]
        if is_file(scene):  # itself, because what it names stands beside it
            name = asked.name
            words += [name, "--json", *arguments]
            for each in settings(set):
                words += ["--set", each]
        else:
            file.write(text)
            file.flush()
            name = file.name
            words += [name, "--json", *arguments]
        found: dict[str, Any] = json.loads(output_of(words, asked.name, name))
    return found
