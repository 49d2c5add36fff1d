"""The blocks of docs/python.md run, in order, as one program; what it quotes stands in the files."""

import contextlib
import io
import os
import re
import unittest

from data import ROOT

PAGE = (ROOT / "docs" / "python.md").read_text()


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)


class Page(unittest.TestCase):
    def test_python_runs(self) -> None:
        names: dict[str, object] = {}
        folder = os.getcwd()
        os.chdir(ROOT)
        try:
            with contextlib.redirect_stdout(io.StringIO()):
                for block in blocks("python"):
                    exec(compile(block, "docs/python.md", "exec"), names)  # noqa: S102
        finally:
            os.chdir(folder)
        self.assertGreater(len(blocks("python")), 8)
        self.assertLess(abs(names["prototype"].object - names["compiled"].object).max(), 1e-11)  # type: ignore[attr-defined]

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

        for name in re.findall(r"lagroid\.(\w+)\(", PAGE) + re.findall(r"^\| (\w+(?:Error|Interrupted)) \|", PAGE, re.M):
            self.assertTrue(hasattr(lagroid, name), name)


if __name__ == "__main__":
    unittest.main()
