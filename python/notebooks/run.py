"""Runs a notebook as Jupyter does, in a kernel of this interpreter and in the notebook's own folder:

    run.py NOTEBOOK [FOLDER]

A cell that fails ends it, with the cell and its traceback. FOLDER gets the notebook with its outputs."""

import json
import os
import re
import sys
import tempfile
from pathlib import Path
from typing import Any

import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError


def execute(file: Path) -> Any:
    """The notebook with its outputs. Raises CellExecutionError, and what a file that is no notebook raises."""
    notebook = nbformat.read(file, as_version=4)
    nbformat.validate(notebook)
    with tempfile.TemporaryDirectory() as own:
        # Neither kernels nor settings of the user: the kernel is this interpreter, which has the package on its path.
        kernel = Path(own) / "kernels" / "this_interpreter" / "kernel.json"
        kernel.parent.mkdir(parents=True)
        command = [sys.executable, "-Xfrozen_modules=off", "-m", "ipykernel_launcher", "-f", "{connection_file}"]
        kernel.write_text(json.dumps({"argv": command, "display_name": "this interpreter", "language": "python"}))
        os.environ.update(JUPYTER_PATH=own, JUPYTER_RUNTIME_DIR=own, IPYTHONDIR=own)
        client = NotebookClient(
            notebook,
            kernel_name="this_interpreter",
            timeout=600,
            resources={"metadata": {"path": str(file.parent)}},
        )
        return client.execute()


def main(file: Path, folder: "Path | None") -> int:
    try:
        notebook = execute(file.resolve())
    except CellExecutionError as error:
        print(f"{file}: {re.sub(chr(27) + r'[^m]*m', '', str(error))}", file=sys.stderr)
        return 1
    if folder:
        folder.mkdir(parents=True, exist_ok=True)
        # Whole or not at all, for the site may be reading.
        unfinished = folder / f".{file.name}"
        nbformat.write(notebook, unfinished)
        unfinished.replace(folder / file.name)
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), Path(sys.argv[2]) if len(sys.argv) > 2 else None))
