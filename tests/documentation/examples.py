"""The programs of examples/cpp print what docs/examples.md says, and are short: examples.py PROGRAMS"""
import pathlib
import sys
import tempfile
import unittest

root = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(root / "docs/site"))
import examples

programs = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else root / "build/release/bin").resolve()


class Examples(unittest.TestCase):
    maxDiff = None

    def test_they_print_what_the_page_says(self):
        self.assertEqual((root / "docs/examples.md").read_text(), examples.page(programs),
                         "write it: ./lagroid pages examples")

    def test_they_are_ten_in_a_row(self):
        self.assertEqual([source.stem[:3] for source in examples.sources], [f"{k:02}_" for k in range(1, 11)])

    def test_they_are_short(self):
        self.assertEqual([source.name for source in examples.sources if len(source.read_text().splitlines()) >= 60], [])

    def test_the_last_is_reduced_by_the_library(self):
        self.assertIn(" reduce(", examples.sources[-1].read_text())
        self.assertIn("#include <lagroid/core/reduction/", examples.sources[-1].read_text())


class BrokenExamples(unittest.TestCase):
    def of(self, text):
        with tempfile.TemporaryDirectory() as folder:
            source = pathlib.Path(folder) / "01_broken.cpp"
            source.write_text(text)
            return examples.parts(source)

    def test_one_that_does_not_say_what_it_is(self):
        run = "// Run: ninja -C build/release 01_broken && build/release/bin/01_broken\n"
        self.assertEqual(self.of(f"// 01  A title.\n//\n// A lesson.\n//\n{run}int main() {{}}\n"),
                         ("A title", ["A lesson."], ["int main() {}"]))
        for text in (f"// A title.\n//\n// A lesson.\n//\n{run}", f"// 01  A title.\n//\n// A lesson.\n{run}",
                     "// 01  A title.\n//\n// A lesson.\n//\n// Run: it\n", "int main() {}\n"):
            with self.assertRaises(ValueError):
                self.of(text)

    def test_one_that_fails(self):
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder) / "01_broken"
            program.write_text("#!/bin/sh\necho no step; exit 1\n")
            program.chmod(0o755)
            with self.assertRaisesRegex(RuntimeError, "no step"):
                examples.printed(pathlib.Path("01_broken.cpp"), pathlib.Path(folder))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])
