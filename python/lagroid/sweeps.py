"""Many members of one scene, on all threads and many machines, by the program `lagroid sweep`."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from . import _lagroid
from .errors import OutputError
from .programs import output_of, program
from .scenes import settings

__all__ = ["Sweep", "sweep"]


@dataclass(frozen=True)
class Sweep:
    """The results of a sweep in its folder; sweep[column] reads one from sweep.h5."""

    folder: Path
    summary: dict[str, Any]  #: how many ended how; least, mean and largest of every column

    @staticmethod
    def read(folder: str | os.PathLike[str]) -> Sweep:
        """That which an earlier sweep left. Raises OutputError where the folder holds none."""
        try:
            summary = json.loads((Path(folder) / "summary.json").read_text())
        except (OSError, ValueError):
            summary = {}
        if "members" not in summary:
            raise OutputError(f'"{os.fspath(folder)}" holds no sweep; lagroid sweep FILE --out DIR makes one')
        return Sweep(Path(folder), summary)

    def __len__(self) -> int:
        """How many members there are."""
        return int(self.summary["members"])

    @property
    def keys(self) -> list[str]:
        """What varies, by dotted keys of the scene."""
        return list(self.summary["design"]["keys"])

    @property
    def columns(self) -> list[str]:
        """Of the members, beside the keys: group/label, as in "final/x"."""
        return list(self.summary["columns"])

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        """(members,), or a series, (members, nodes): of a key, or of group/label. NaN where a member has none."""
        label = f"keys/{name}" if name in self.keys else name
        values = _lagroid.read_hdf5(self.folder / "sweep.h5", f"/{label}")
        return values[:, 0] if values.shape[1] == 1 else values


def sweep(
    file: str | os.PathLike[str],
    *,
    out: str | os.PathLike[str],
    set: Optional[Mapping[str, Any]] = None,
    threads: int = 0,
    ranks: int = 1,
    other_build: bool = False,
) -> Sweep:
    """Runs a sweep file (docs/sweeps.md) into the folder `out`, where the same call goes on after an interrupt.
    `threads` of each process, all by default; more than one of `ranks` are started by mpirun. With `other_build` it goes
    on from what another build of lagroid left, without the promise of the same bits. Members that failed are NaN: see
    `summary`. Raises SceneError, OutputError, and KeyboardInterrupt after Ctrl-C."""
    name = os.fspath(file)
    command = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
    command += [program("lagroid", "LAGROID_PROGRAM", "lagroid_cli"), "sweep", name, "--out", os.fspath(out), "--json"]
    command += ["--threads", str(threads)] if threads else []
    command += ["--other-build"] if other_build else []
    for each in settings(set):
        command += ["--set", each]
    summary = json.loads(output_of(command, name, name))
    if "members" not in summary:
        raise OutputError(summary["message"])
    return Sweep(Path(out), summary)
