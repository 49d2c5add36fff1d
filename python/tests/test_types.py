"""The stubs say what the module has, and the package, notebooks and tests keep to them."""

import ast
import subprocess
import sys
import tempfile
import unittest
from importlib import util
from pathlib import Path

import lagroid
from data import NOTEBOOKS, ROOT, code_of
from lagroid import _lagroid


@unittest.skipUnless(util.find_spec("mypy"), "mypy is not installed")
class Checked(unittest.TestCase):
    def mypy(self, *files: str) -> "subprocess.CompletedProcess[str]":
        return subprocess.run(
            [sys.executable, "-m", "mypy", "--config-file", str(ROOT / "pyproject.toml"), "--cache-dir", "/dev/null",
             *files],
            capture_output=True,
            text=True,
            check=False,
            cwd=ROOT / "python",
        )  # fmt: skip

    def test_package_and_notebooks(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            files = [Path(folder) / f"{notebook.stem}.py" for notebook in NOTEBOOKS]
            for file, notebook in zip(files, NOTEBOOKS):
                file.write_text(code_of(notebook))
            found = self.mypy("lagroid", "bench/overhead.py", *map(str, files))
        self.assertEqual(found.returncode, 0, found.stdout)

    def test_a_mistake_is_found(self) -> None:
        sound = self.mypy("-c", "import lagroid\nlagroid.run('a', record=False)")
        self.assertEqual(sound.returncode, 0, sound.stdout + sound.stderr)
        found = self.mypy("-c", "import lagroid\nlagroid.run('a', steps=3)")
        self.assertEqual(found.returncode, 1, found.stderr)
        self.assertIn('Unexpected keyword argument "steps"', found.stdout)


class Stubs(unittest.TestCase):
    def test_every_name_has_its_stub(self) -> None:
        stub = ast.parse((ROOT / "python" / "lagroid" / "_lagroid.pyi").read_text())
        classes = {node.name: node for node in stub.body if isinstance(node, ast.ClassDef)}
        functions = {node.name for node in stub.body if isinstance(node, ast.FunctionDef)}
        functions |= {node.target.id for node in stub.body if isinstance(node, ast.AnnAssign)}  # type: ignore[union-attr]
        for name in dir(_lagroid):
            value = getattr(_lagroid, name)
            if name.startswith("__"):
                continue
            if isinstance(value, type):
                own = {member for member in vars(value) if not member.startswith("_")}
                self.assertEqual(own, self.inherited(name, classes), name)
            else:
                self.assertIn(name, functions)

    def inherited(self, name: str, classes: dict[str, ast.ClassDef]) -> set[str]:
        """The members that the stub of a class has, its bases' among them."""
        if name not in classes:
            return set()
        bases = [base.id for base in classes[name].bases if isinstance(base, ast.Name)]
        return self.members(classes[name]).union(*(self.inherited(base, classes) for base in bases))

    @staticmethod
    def members(node: ast.ClassDef) -> set[str]:
        out = {item.name for item in node.body if isinstance(item, ast.FunctionDef)}
        for item in node.body:
            if isinstance(item, ast.AnnAssign) and isinstance(item.target, ast.Name):
                out.add(item.target.id)
        return {name for name in out if not name.startswith("_")}

    def test_everything_public_has_a_docstring(self) -> None:
        for name in lagroid.__all__:
            value = getattr(lagroid, name)
            if name.startswith("_"):
                continue
            self.assertTrue(value.__doc__, name)
            if not isinstance(value, type) or value.__module__ != _lagroid.__name__:
                continue
            for member, item in vars(value).items():
                if member.startswith("_"):
                    continue
                # A function's begins with its signature.
                told = item.__doc__ or ""
                self.assertTrue(told.partition("\n\n")[2] if callable(item) else told, f"{name}.{member}")


if __name__ == "__main__":
    unittest.main()
