"""Where things are."""

import json
import os
from importlib import util
from pathlib import Path
from typing import Optional

from lagroid.errors import ProgramError
from lagroid.programs import program

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples"
NOTEBOOKS = sorted((ROOT / "python" / "notebooks").glob("*.ipynb"))


def code_of(notebook: Path) -> str:
    """The Python of a notebook, cell by cell; magics, which are IPython's own, are left out."""
    cells = json.loads(notebook.read_text())["cells"]
    lines = "\n\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code").splitlines()
    return "\n".join(line for line in lines if not line.startswith("%")) + "\n"


def gradient_program(system: str) -> Optional[str]:
    """lagroid-gradient: that of one system, which is built with the tests, or that of all."""
    part = Path(os.environ.get("LAGROID_BUILD", "")) / "bin" / "parts" / system / "lagroid-gradient"
    if part.is_absolute() and part.exists():
        return str(part)
    try:
        return program("lagroid-gradient", "LAGROID_GRADIENT", "lagroid_gradient")
    except ProgramError:
        return None


def without_torch(system: str = "pendulum") -> str:
    """Why runs of a system are not to be differentiated by lagroid.torch here; empty where they are."""
    if not util.find_spec("torch"):
        return "python3-torch is not installed"
    return "" if gradient_program(system) else "lagroid-gradient is not built: ninja lagroid_gradient"
