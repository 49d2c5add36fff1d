"""Python on pages runs, in order, as one program a page; what docs/python.md quotes stands in the files."""

import contextlib
import io
import os
import re
import unittest

from data import ROOT

PAGE = (ROOT / "docs" / "python.md").read_text()


def blocks(language: str, page: str = PAGE) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)


def run(page: str) -> dict[str, object]:
    """What the page's program leaves."""
    names: dict[str, object] = {}
    folder = os.getcwd()
    os.chdir(ROOT)
    try:
        with contextlib.redirect_stdout(io.StringIO()):
            for block in blocks("python", (ROOT / "docs" / page).read_text()):
                exec(compile(block, f"docs/{page}", "exec"), names)  # noqa: S102
    finally:
        os.chdir(folder)
    return names


class ComingFrom(unittest.TestCase):
    def test_first_programs_run(self) -> None:
        names = run("coming_from.md")
        self.assertTrue(names["solution"].converged)  # type: ignore[attr-defined]
        self.assertEqual(names["centre"].status, "converged")  # type: ignore[attr-defined]
        self.assertGreater(names["centre"].x[2], 0.9)  # type: ignore[attr-defined]


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
        import lagroid

        errors = re.findall(r"^\| (\w+(?:Error|Interrupted)) \|", PAGE, re.M)
        for name in re.findall(r"lagroid\.(\w+)\(", PAGE) + errors:
            self.assertTrue(hasattr(lagroid, name), name)


if __name__ == "__main__":
    unittest.main()
