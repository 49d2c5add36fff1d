"""The notebooks are as they are kept: valid, without outputs. A cell that fails is told by what runs them."""

import os
import subprocess
import sys
import tempfile
import unittest
from importlib import util
from pathlib import Path

from data import NOTEBOOKS, ROOT

RUN = ROOT / "python" / "notebooks" / "run.py"


@unittest.skipUnless(util.find_spec("nbclient"), "nbclient is not installed")
class Notebooks(unittest.TestCase):
    def test_are_valid_and_without_outputs(self) -> None:
        import nbformat

        self.assertGreater(len(NOTEBOOKS), 4)
        for file in NOTEBOOKS:
            notebook = nbformat.read(file, as_version=4)
            nbformat.validate(notebook)
            self.assertEqual(notebook.cells[0].cell_type, "markdown", file)
            for cell in notebook.cells:
                if cell.cell_type == "code":
                    self.assertEqual((cell.outputs, cell.execution_count), ([], None), f"{file}: {cell.source}")

    def run_of(self, *cells: str) -> "tuple[subprocess.CompletedProcess[str], str]":
        """What running such cells gives, and the notebook that it leaves."""
        from nbformat import v4, write

        with tempfile.TemporaryDirectory() as folder:
            file, out = Path(folder) / "cells.ipynb", Path(folder) / "out"
            write(v4.new_notebook(cells=[v4.new_code_cell(each) for each in cells]), file)
            found = subprocess.run(
                [sys.executable, RUN, file, out], capture_output=True, text=True, check=False, env=os.environ
            )
            left = out / file.name
            return found, left.read_text() if left.exists() else ""

    def test_have_the_package(self) -> None:
        found, left = self.run_of("import lagroid", "print(lagroid.__file__)")
        self.assertEqual(found.returncode, 0, found.stderr)
        import lagroid

        self.assertIn(lagroid.__file__, left)

    def test_a_cell_that_fails_is_told(self) -> None:
        found, left = self.run_of("whole = 1", "def halve(x):\n    return x / 0\nhalve(whole)", "print('after')")
        self.assertEqual(found.returncode, 1)
        self.assertIn("cells.ipynb", found.stderr)
        self.assertIn("----> 2     return x / 0", found.stderr)
        self.assertIn("ZeroDivisionError", found.stderr)
        self.assertEqual(left, "")


if __name__ == "__main__":
    unittest.main()
