"""What can go wrong. Every message is one line: where, what is wrong, what to do."""

from __future__ import annotations

from typing import TYPE_CHECKING, Optional

if TYPE_CHECKING:
    from ._lagroid import RunResult, Trajectory
    from .prototype import PrototypeTrajectory

__all__ = ["DataError", "Error", "Interrupted", "OutputError", "ProgramError", "SceneError", "SolveError"]


class Error(Exception):
    """Base of all but Interrupted."""


class SceneError(Error, ValueError):
    """A mistake in a scene: which file, line and key, and what to do."""


class DataError(Error, ValueError):
    """A file without the data or the model that it should hold."""


class OutputError(Error, OSError):
    """A folder that cannot be written, or that holds no run to go on from."""


class ProgramError(Error, RuntimeError):
    """The program lagroid-check is missing or ended with an error."""


class SolveError(Error, RuntimeError):
    """A step or a boundary value that was not solved: its `status` (docs/scenes.md), and the `result` as far as it
    came, where there is one."""

    def __init__(
        self,
        message: str,
        status: str = "not_converged",
        result: Optional[RunResult | Trajectory | PrototypeTrajectory] = None,
    ) -> None:
        super().__init__(message)
        self.status = status
        self.result = result


class Interrupted(KeyboardInterrupt):
    """Ctrl-C during a run: `result` holds what was computed."""

    def __init__(self, result: RunResult) -> None:
        super().__init__(result.message)
        self.result = result
