"""Python on pages runs, in order, as one program a page; what docs/python.md quotes stands in the files."""

import contextlib
import io
import os
import re
import unittest
import warnings
from unittest import mock

from data import ROOT, gradient_program, without_torch

import lagroid
from lagroid import compat

PAGE = (ROOT / "docs" / "python.md").read_text()


def blocks(language: str, page: str = PAGE) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)


def run(page: str) -> dict[str, object]:
    """What the page's program leaves, without blocks for which PyTorch is missing. A retired name in it is an error."""
    names: dict[str, object] = {}
    folder = os.getcwd()
    os.chdir(ROOT)
    programs = {"LAGROID_GRADIENT": gradient_program("pendulum") or ""}
    try:
        with (
            contextlib.redirect_stdout(io.StringIO()),
            warnings.catch_warnings(),
            mock.patch.dict(os.environ, programs),
        ):
            warnings.simplefilter("error", DeprecationWarning)
            for block in blocks("python", (ROOT / "docs" / page).read_text()):
                if "lagroid.torch" in block and without_torch():
                    continue
                exec(compile(block, f"docs/{page}", "exec"), names)  # noqa: S102
    finally:
        os.chdir(folder)
    return names


def unknown_names(page: str) -> set[str]:
    """Of the code in the last column of the page's tables, what is no name in our headers, no word of scenes and
    commands and no name in Python; of what its Python takes from the package, what is not there or is retired."""
    cells = re.findall(r"^\|.*(?<!\\)\|(.*)\|$", page, re.MULTILINE)
    code = " ".join(span for cell in cells for span in re.findall(r"`([^`]*)`", cell))
    words = set(re.findall(r"[A-Za-z_]\w+", code))
    known = {"lagroid", *(name for each in lagroid.__all__ for name in (each, *dir(getattr(lagroid, each))))}
    for layer in ("core", "groupoids", "solvers", "systems", "run", "app"):
        for path in (ROOT / layer).rglob("*.[hc]pp"):
            text = re.sub("//.*", "", path.read_text())
            if path.suffix == ".hpp":
                known |= {path.stem, *path.relative_to(ROOT).parts, *re.findall(r"[A-Za-z_]\w+", text)}
            known |= {word for quoted in re.findall(r'"([\w -]+)"', text) for word in re.findall(r"\w+", quoted)}
    taken = {name for block in blocks("python", page) for name in re.findall(r"\blagroid\.(\w+)", block)}
    return (words - known) | {name for name in taken if name in compat.NAMES or not hasattr(lagroid, name)}


class ComingFrom(unittest.TestCase):
    page = (ROOT / "docs" / "coming_from.md").read_text()

    def test_first_programs_run(self) -> None:
        names = run("coming_from.md")
        self.assertTrue(names["solution"].converged)  # type: ignore[attr-defined]
        self.assertEqual(names["centre"].status, "converged")  # type: ignore[attr-defined]
        self.assertGreater(names["centre"].x[2], 0.9)  # type: ignore[attr-defined]

    def test_our_words_are_names_of_ours(self) -> None:
        self.assertGreater(self.page.count("|---|"), 4)
        self.assertEqual(unknown_names(self.page), set())

    def test_a_retired_name_is_found_out(self) -> None:
        table = "| there | here |\n|---|---|\n| `solve` | `make_march`, then `Sphere` or `hinge` |\n"
        self.assertEqual(unknown_names(table), {"make_march"})
        block = "```python\nlagroid.Pairs(1), lagroid.Pair(1), lagroid.pears\n```\n"
        self.assertEqual(unknown_names(block), {"Pairs", "pears"})


class Page(unittest.TestCase):
    def test_python_runs(self) -> None:
        names = run("python.md")
        self.assertGreater(len(blocks("python")), 8)
        prototype, compiled = names["prototype"], names["compiled"]
        self.assertLess(abs(prototype.object - compiled.object).max(), 1e-11)  # type: ignore[attr-defined]

    def test_cpp_is_that_of_the_template(self) -> None:
        source = (ROOT / "python" / "template" / "my_system.cpp").read_text()
        self.assertTrue(blocks("cpp"))
        for block in blocks("cpp"):
            self.assertIn(block, source)

    def test_files_exist(self) -> None:
        for name in re.findall(r"\]\(([\w./]+)\)", PAGE):
            self.assertTrue((ROOT / "docs" / name).exists(), name)
        for name in re.findall(r"(?<![\w./])python/[\w/.]*\w", PAGE):
            self.assertTrue((ROOT / name).exists(), name)

    def test_classes_exist(self) -> None:
        errors = re.findall(r"^\| (\w+(?:Error|Interrupted)) \|", PAGE, re.M)
        for name in re.findall(r"lagroid\.(\w+)\(", PAGE) + errors:
            self.assertTrue(hasattr(lagroid, name), name)


if __name__ == "__main__":
    unittest.main()
