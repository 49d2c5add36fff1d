"""The programs that stand beside the module: what compiles for minutes, or runs on many machines."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
from pathlib import Path

from . import _lagroid
from .errors import ProgramError, SceneError


def program(name: str, variable: str, target: str) -> str:
    """Where the program is: as the variable says, on PATH, or in the build tree of the module."""
    found = os.environ.get(variable) or shutil.which(name)
    if not found and _lagroid.__file__ is not None:
        beside = Path(_lagroid.__file__).parents[2] / "bin" / name
        found = str(beside) if beside.exists() else None
    if not found:
        raise ProgramError(
            f"the program {name} is not there: build its target (ninja {target}), and put it on PATH or name it in "
            f"{variable}"
        )
    return found


def output_of(command: list[str], scene: str, file: str) -> str:
    """What the command prints. Ctrl-C goes to it, and is raised when it has ended. Raises SceneError where it refuses
    its input, of which it says `file` and we say `scene`."""
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as started:
        try:
            output, complaint = started.communicate()
        except KeyboardInterrupt:
            started.send_signal(signal.SIGINT)
            started.communicate()
            raise
    message = complaint.strip().removeprefix("lagroid: ").replace(file, scene)
    if started.returncode == 2:
        raise SceneError(message)
    if started.returncode == 4:
        raise KeyboardInterrupt(message)
    if started.returncode not in (0, 3) or not output.strip():
        raise ProgramError(message or f"{command[0]} ended with {started.returncode}")
    return output
