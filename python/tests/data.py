"""Where things are."""

import json
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples"
NOTEBOOKS = sorted((ROOT / "python" / "notebooks").glob("*.ipynb"))


def code_of(notebook: Path) -> str:
    """The Python of a notebook, cell by cell; magics, which are IPython's own, are left out."""
    cells = json.loads(notebook.read_text())["cells"]
    lines = "\n\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code").splitlines()
    return "\n".join(line for line in lines if not line.startswith("%")) + "\n"
