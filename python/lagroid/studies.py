"""What accuracy costs a scene, and the laws asked of its system."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple, Optional

from . import _lagroid
from .errors import ProgramError, SceneError
from .scenes import SceneLike, made

__all__ = ["Method", "check", "methods", "study"]


class Method(NamedTuple):
    """A way to march a scene: its name, its order, and what [time] holds for it."""

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
    repetitions: int = 5,
    out: Optional[str | os.PathLike[str]] = None,
) -> dict[str, Any]:
    """Error against time and evaluations by all methods whose names match (["splitting*"]; all by default), as
    `lagroid study --json` tells it (docs/which_method.md).

    `steps`: sizes in s, or found: halved until errors are those of round-off or a run lasts `longest` s. `target`: the
    error for which a method is recommended. `reference_time`: seconds that the reference may take. `out`: a folder for
    its page and figures. Raises KeyboardInterrupt after Ctrl-C."""
    found: dict[str, Any] = json.loads(
        _lagroid.study(
            made(scene, set), ",".join(methods), list(steps), target, longest, reference_time, repetitions, out
        )
    )
    return found


def _checker() -> str:
    found = os.environ.get("LAGROID_CHECK") or shutil.which("lagroid-check")
    if not found and _lagroid.__file__ is not None:
        beside = Path(_lagroid.__file__).parents[2] / "bin" / "lagroid-check"  # in the build tree
        found = str(beside) if beside.exists() else None
    if not found:
        raise ProgramError(
            "the program lagroid-check is not there: build its target (ninja lagroid_check), and put it on PATH or "
            "name it in LAGROID_CHECK"
        )
    return found


def check(
    scene: SceneLike, *, set: Optional[Mapping[str, Any]] = None, arguments: Sequence[str] = ()
) -> dict[str, Any]:
    """Asks the scene's system every law, from groupoid axioms to Noether, by the program lagroid-check, in which the
    laws are compiled: the certificate that it prints with --json. `arguments` go to it as they are. Raises ProgramError
    where it is missing, SceneError where it refuses the scene."""
    asked = made(scene, set)
    with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
        file.write(asked.toml())
        file.flush()
        program = subprocess.run(
            [_checker(), file.name, "--json", *arguments], capture_output=True, text=True, check=False
        )
    complaint = program.stderr.strip().removeprefix("lagroid: ").replace(file.name, asked.name)
    if program.returncode == 2:
        raise SceneError(complaint)
    try:
        certificate: dict[str, Any] = json.loads(program.stdout)
    except json.JSONDecodeError:
        raise ProgramError(f"lagroid-check ended with {program.returncode}: {complaint}") from None
    return certificate
