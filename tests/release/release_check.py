"""`./lagroid release`, with pieces of a moment in a repository of its own: release_check.py"""
import contextlib
import io
import pathlib
import re
import subprocess
import tempfile
import unittest

import pieces as declared
from pieces import Piece
from release import Release, journal_of_it, main, page_of_it


class Pieces(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        (self.root / "docs").mkdir()
        (self.root / ".gitignore").write_text("build/\n")
        self.git("init", "-q")
        self.git("config", "user.name", "A. Tester")
        self.git("config", "user.email", "tester@example.org")
        self.commit("source", "1")

    def git(self, *words):
        subprocess.run(["git", *words], cwd=self.root, check=True, capture_output=True)

    def commit(self, name, text):
        (self.root / name).write_text(text)
        self.git("add", "-A")
        self.git("commit", "-q", "-m", name)

    def run_pieces(self, pieces, *arguments, limit=60):
        """The exit code, and what was said."""
        said = io.StringIO()
        with contextlib.redirect_stderr(said), contextlib.redirect_stdout(said):
            code = main(list(arguments), Release(self.root, pieces, limit))
        return code, said.getvalue()

    def counted(self, name="counted"):
        """A piece, and how often it ran."""
        return Piece(name, "counts", (f"echo >> build/{name}",))

    def runs(self, name="counted"):
        path = self.root / "build" / name
        return len(path.read_text().splitlines()) if path.exists() else 0

    def results(self, pieces):
        return {name: entry["result"] for name, entry in Release(self.root, pieces).done().items()}

    def test_what_passed_is_run_again_only_where_asked_or_on_another_commit(self):
        pieces = [self.counted()]
        for arguments, runs in (([], 1), ([], 1), (["counted"], 1), (["--again", "counted"], 2)):
            self.assertEqual(self.run_pieces(pieces, *arguments)[0], 0)
            self.assertEqual(self.runs(), runs)
        self.commit(page_of_it, "the page alone is no other commit")
        self.run_pieces(pieces)
        self.assertEqual(self.runs(), 2)
        self.git("checkout", "-q", "--", ".")
        self.commit("source", "2")
        self.run_pieces(pieces)
        self.assertEqual(self.runs(), 3)

    def test_the_page_says_on_which_commit_a_piece_last_ran(self):
        pieces = [self.counted("first"), self.counted("second")]
        self.run_pieces(pieces, "first")
        self.git("checkout", "-q", "--", ".")
        self.commit("source", "2")
        self.run_pieces(pieces, "second")
        page = (self.root / page_of_it).read_text()
        commits = {name: Release(self.root, pieces).latest(name)["commit"] for name in ("first", "second")}
        self.assertNotEqual(*commits.values())
        for name, commit in commits.items():
            self.assertRegex(page, rf"\| {name} \| .* \| passed \| .* \| {commit[:10]} \|")
        # What another branch saw is not of this one.
        journal = (self.root / journal_of_it).read_text()
        self.git("checkout", "-q", "-f", "HEAD~1")
        (self.root / "docs").mkdir(exist_ok=True)
        (self.root / journal_of_it).write_text(journal)
        self.assertEqual(Release(self.root, pieces).latest("second"), {"result": "not yet"})

    def test_another_machine_knows_what_ran_once_that_is_committed(self):
        pieces = [self.counted()]
        self.run_pieces(pieces)
        self.git("add", "-A")
        self.git("commit", "-q", "-m", "what ran")
        elsewhere = self.root / "build/elsewhere"
        self.git("clone", "-q", ".", str(elsewhere))
        self.assertEqual(Release(elsewhere, pieces).latest("counted")["result"], "passed")
        self.assertEqual(Release(elsewhere, pieces).missing(), [])

    def test_a_cut_run_goes_on_with_the_next_piece(self):
        def cut():
            raise KeyboardInterrupt
        with self.assertRaises(KeyboardInterrupt):
            self.run_pieces([self.counted("first"), Piece("second", "is cut", (), cut)])
        self.assertEqual(self.run_pieces([self.counted("first"), self.counted("second")])[0], 0)
        self.assertEqual((self.runs("first"), self.runs("second")), (1, 1))

    def test_a_failing_piece_is_told_and_stops_no_other(self):
        pieces = [Piece("broken", "fails", ("echo before", "exit 3", "touch build/never")), self.counted()]
        code, said = self.run_pieces(pieces)
        self.assertEqual((code, self.runs()), (1, 1))
        self.assertIn("not passed: broken", said)
        self.assertFalse((self.root / "build/never").exists())
        self.assertIn("| failed |", (self.root / page_of_it).read_text())
        self.assertIn("`exit 3` ended with 3", (self.root / page_of_it).read_text())
        self.assertEqual(self.run_pieces(pieces, "counted")[0], 0)

    def test_what_cannot_run_here_says_why(self):
        pieces = [Piece("afar", "needs a network", ("touch build/never",), lambda: "no network")]
        self.assertEqual(self.run_pieces(pieces)[0], 0)
        self.assertFalse((self.root / "build/never").exists())
        self.assertRegex((self.root / page_of_it).read_text(), r"\| afar \| .* \| not run \| .* \| no network \|")

    def test_tests_of_a_build_that_failed_are_not_run(self):
        pieces = [Piece("a_build", "fails", ("exit 1",)), Piece("tests", "of it", ("touch build/never",), after="a_build")]
        self.assertEqual(self.run_pieces(pieces)[0], 1)
        self.assertEqual(self.results(pieces), {"a_build": "failed", "tests": "not run"})
        self.assertFalse((self.root / "build/never").exists())

    def test_an_hour_ends_a_piece_and_a_build_goes_on(self):
        pieces = [Piece("tests", "last", ("sleep 60",)), Piece("a_build", "lasts", ("sleep 60",), goes_on=True)]
        self.assertEqual(self.run_pieces(pieces, limit=0.2)[0], 1)
        self.assertEqual(self.results(pieces), {"tests": "failed", "a_build": "unfinished"})

    def test_changed_sources_are_refused(self):
        (self.root / "source").write_text("changed")
        code, said = self.run_pieces([self.counted()])
        self.assertEqual((code, self.runs()), (2, 0))
        self.assertIn("source", said)

    def test_a_page_that_comes_out_otherwise_fails_and_is_put_aside(self):
        pieces = [Piece("pages", "are made", ("echo other > source",), writes=True), self.counted()]
        self.assertEqual(self.run_pieces(pieces)[0], 1)
        self.assertEqual(self.results(pieces), {"pages": "failed", "counted": "passed"})
        self.assertEqual((self.root / "source").read_text(), "1")

    def test_a_list_runs_nothing_and_names_are_known(self):
        code, said = self.run_pieces([self.counted()], "--list")
        self.assertEqual((code, self.runs()), (0, 0))
        self.assertRegex(said, r"counted +not yet")
        with self.assertRaises(SystemExit):
            self.run_pieces([self.counted()], "another")


class Declared(unittest.TestCase):
    """The pieces of the project name what is there."""

    def test_names_are_different(self):
        self.assertEqual(len({piece.name for piece in declared.pieces}), len(declared.pieces))

    def test_presets_pages_and_tests_exist(self):
        presets = (declared.root / "CMakePresets.json").read_text()
        script = (declared.root / "lagroid").read_text()
        lists = "".join((declared.root / folder / "CMakeLists.txt").read_text() for folder in ("tests", "docs", "python"))
        for piece in declared.pieces:
            for command in piece.commands:
                for preset in re.findall(r"--preset (\S+)", command):
                    self.assertIn(f'"name": "{preset}"', presets, piece.name)
                for page in re.findall(r"lagroid pages (\S+)", command):
                    self.assertIn(f"if wants {page};", script, piece.name)
        for names in ("Documentation.LinksAreAnswered", "Documentation.ExamplesOfHeadersCompile", "lagroid_python_test(install",
                      "NAME installed_whole", "NAME own_program_whole", "NAME clean_root"):
            self.assertIn(names, lists)


if __name__ == "__main__":
    unittest.main()
