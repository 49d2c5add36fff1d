"""Scenes and their runs."""

from __future__ import annotations

import copy
import json
import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional, TypeVar, Union

import numpy as np

from . import _lagroid
from ._lagroid import RunResult, Trajectory
from .errors import Interrupted, SceneError, SolveError

if TYPE_CHECKING:
    from .prototype import PrototypeTrajectory

SceneLike = Union[str, "os.PathLike[str]", Mapping[str, Any]]
_Result = TypeVar("_Result", bound=Union[RunResult, Trajectory, "PrototypeTrajectory"])

__all__ = ["SceneLike", "reductions", "require", "resume", "run", "scene_text", "systems"]


def _toml(value: Any, key: str) -> str:
    """A value as TOML; tables are written inline."""
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, os.PathLike):
        return _toml(os.fspath(value), key)
    if isinstance(value, np.ndarray):
        return _toml(value.tolist(), key)
    if isinstance(value, Mapping):
        inner = ", ".join(f"{json.dumps(str(k))} = {_toml(v, f'{key}.{k}')}" for k, v in value.items())
        return "{" + inner + "}"
    if isinstance(value, Sequence):
        return "[" + ", ".join(_toml(v, key) for v in value) + "]"
    raise SceneError(f"{key}: a scene holds numbers, texts, arrays and tables, not {type(value).__name__}")


def scene_text(scene: Mapping[str, Any]) -> str:
    """The scene of a dict as TOML: its tables are dicts, its arrays lists or NumPy arrays."""
    return "".join(f"{json.dumps(str(key))} = {_toml(value, str(key))}\n" for key, value in scene.items())


def settings(given: Optional[Mapping[str, Any]]) -> list[str]:
    """Values at dotted keys as key=value."""
    return [f"{key}={_toml(value, key)}" for key, value in (given or {}).items()]


def is_file(scene: SceneLike) -> bool:
    """Whether the scene is the name of a file."""
    return not isinstance(scene, Mapping) and not (isinstance(scene, str) and "\n" in scene)


def made(scene: SceneLike, given: Optional[Mapping[str, Any]]) -> _lagroid.Scene:
    """The scene of a file, a text or a dict, with other values at dotted keys."""
    overrides = settings(given)
    if isinstance(scene, Mapping):
        return _lagroid.Scene.text(scene_text(scene), "<dict>", overrides)
    if isinstance(scene, str) and not is_file(scene):
        return _lagroid.Scene.text(scene, "<text>", overrides)
    if not isinstance(scene, (str, os.PathLike)):
        raise TypeError(
            f"a scene is the name of a file, a TOML text or a dict, not {type(scene).__name__}: runs, studies and "
            "checks are of lagroid.systems(); a system of your own has integrator(...), and its laws are asked in C++ "
            "(docs/tutorial.md)"
        )
    return _lagroid.Scene.file(scene, overrides)


def run(
    scene: SceneLike,
    *,
    set: Optional[Mapping[str, Any]] = None,
    reduce: Optional[str] = None,
    events: Optional[Sequence[Mapping[str, Any]]] = None,
    record: bool = True,
    out: Optional[str | os.PathLike[str]] = None,
) -> RunResult:
    """Runs a scene (docs/scenes.md): a file, a TOML text (a str with more than one line) or a dict.

    `set` holds other values by dotted keys, as in {"time.steps": 100}. `reduce` names one of the system's reductions
    (`reductions(name)` has them): its steps are then those of the reduced system, its motion the full one.
    `events` are the tables [[event]] of the scene (docs/events.md), as in [{"name": "bottom", "when": "q"}]; `when` may be a function of
    the node, as in `lambda node: node["q"] - 0.5`, and `call` one that is called where it has happened and ends the run
    by returning False. RunResult.events has what happened. Without `record` only the ledger and the end points are kept. `out` is a folder for checkpoints and the
    files of `lagroid run --out`.

    Returns also where a step failed: see `status`, or call `require`. Raises SceneError, OutputError, and Interrupted
    after Ctrl-C. Other threads of Python go on meanwhile."""
    called = [dict(event) for event in events or [] if callable(event.get("when")) or "call" in event]
    tables = [event for event in events or [] if not (callable(event.get("when")) or "call" in event)]
    named = {"reduce": reduce, "event": tables if tables else None}
    given = {**(set or {}), **{key: value for key, value in named.items() if value is not None}}
    asked = made(scene, given)
    result = _lagroid.run(asked, record, out, called)
    if not called:  # functions of Python's are in no scene
        # A file itself, as what it names stands beside it; any other as it was set.
        if isinstance(scene, Mapping) or not is_file(scene):
            result._of = (asked.toml(), {})
        else:
            result._of = (os.path.abspath(scene), copy.deepcopy(given))
    return _finished(result)


def resume(folder: str | os.PathLike[str], *, steps: Optional[int] = None, other_build: bool = False) -> RunResult:
    """Goes on with a run that was broken off, or with a finished one to more steps. Raises OutputError where the folder
    holds none, or one by another build of lagroid, unless `other_build`: the same bits are not promised then."""
    return _finished(_lagroid.resume(folder, steps, other_build))


def _finished(result: RunResult) -> RunResult:
    if result.interrupted:
        raise Interrupted(result)
    return result


def require(result: _Result) -> _Result:
    """The result of a run or a trajectory, if it was solved. Raises SolveError where it was not."""
    if not result.converged:
        raise SolveError(result.message, result.status, result)
    return result


def systems() -> dict[str, dict[str, Any]]:
    """The systems that a scene can name: summary, groupoid, parameters, symmetries, conserved quantities,
    reductions."""
    return {entry["name"]: entry for entry in json.loads(_lagroid.listing())}


def reductions(system: str) -> dict[str, dict[str, str]]:
    """What run(..., reduce=...) takes for a system of scenes: of each name its meaning and the groupoid that is reduced
    to. Empty for a system that declares none. Raises ValueError for a system that scenes do not know."""
    known = systems()
    if system not in known:
        raise ValueError(f"reductions: no system {system!r}; those of scenes are {', '.join(known)}")
    return {each.pop("name"): each for each in known[system]["reductions"]}
