"""The page of the architecture and its picture are those of the tree, and the decisions are listed and name what exists."""
import pathlib
import re
import sys
import tempfile
import unittest

from pages import root

sys.path.insert(0, str(root / "docs/site"))
import architecture

page = (root / "docs/architecture.md").read_text()


def number_of(name):
    return int(name.split("_")[0])


decisions = sorted((path for path in (root / "docs/decisions").glob("*.md") if path.name != "index.md"),
                   key=lambda path: number_of(path.name))


def folders_of(text, top):
    """The folders that the list names: in each entry from the first on, unless they are of the top."""
    named = set()
    for entry in re.findall(r"^- .*(?:\n  .*)*", text.split("\n## Folders\n")[1].split("\n## ")[0], re.M):
        first, *others = re.findall(r"`([\w/]+)/`", entry)
        named |= {first, *(f"{first}/{other}" if (top / first / other).is_dir() else other for other in others)}
    return named


def folders_in(top):
    """Those of the tree: all of the layers, and what else lies at the top."""
    def kept(path):
        return path.is_dir() and not path.name.startswith((".", "_")) and path.name not in ("build", "out", "include")

    at_top = {path.name for path in top.iterdir() if kept(path)}
    inside = {str(path.relative_to(top)) for layer in architecture.layers if (top / layer).is_dir()
              for path in (top / layer).glob("*" if layer == "python" else "**/*") if kept(path)}
    return at_top | inside


def unknown_paths(text):
    """Paths in backquotes of which there is nothing in the tree, those of a build apart; in capitals, any will do."""
    names = re.findall(r"`(?!build/)((?:\.?\w+/)+[\w.-]*)`", text)
    return [name for name in names if not list(root.glob(re.sub(r"\b[A-Z]+\b", "*", name).rstrip("/")))
            and not any(list(root.glob(f"{layer}/{name}")) for layer in architecture.layers)
            and not (root / "docs" / name).exists()]


type_begun = re.compile(r"(?:template <.*> )?(?:struct|class|enum class) (\w+)(?: final)?(?: : .*)? \{")


def types_of(text):
    """Types that a file defines, with their namespaces, but for those of nameless ones and specialisations."""
    spaces = []
    for line in text.splitlines():
        if begun := re.match(r"(?:inline )?namespace ?([\w:]*) ?\{$", line):
            spaces.append(begun[1])
        elif spaces and re.match(r"\}  // namespace", line):
            spaces.pop()
        elif "" not in spaces and (found := type_begun.match(line)):
            yield "::".join([*spaces, found[1]])


def types_of_one_name(top):
    """Names of more than one type, which a program that links both would mix up, with the files that define them. One in
    `detail` hides one outside."""
    files = {}
    for path in sorted(path for layer in architecture.layers for path in (top / layer).rglob("*.[ch]pp")):
        for name in types_of(path.read_text()):
            files.setdefault(name.replace("::detail", ""), set()).add(str(path.relative_to(top)))
    return {name: where for name, where in files.items() if len(where) > 1}


class Architecture(unittest.TestCase):
    maxDiff = None

    def test_a_name_is_of_one_type(self):
        self.assertEqual(types_of_one_name(root), {})

    def test_layers_are_those_of_the_test_of_includes(self):
        tests = "".join(path.read_text() for path in sorted((root / "tests").glob("**/*.[ch]pp")))
        (listed,) = re.findall(r"> layers\{([^}]*)\}", tests)
        self.assertEqual(re.findall(r"\w+", listed), [layer for layer in architecture.layers if layer != "python"])

    def test_layers_include_those_before_them(self):
        self.assertEqual(architecture.upward(architecture.includes()), [])

    def test_picture_shows_the_includes_and_the_folders(self):
        drawn = architecture.picture.read_text()
        self.assertEqual(architecture.shown(drawn), architecture.includes(), "draw it: ./lagroid pages architecture")
        words = set(re.findall(r"\w+", " ".join(re.findall(r"<text[^>]*>([^<]*)</text>", drawn))))
        rooms = {room for layer in architecture.layers for room in architecture.rooms(layer)}
        self.assertEqual(rooms - words, set(), "draw it: ./lagroid pages architecture")

    def test_list_of_folders_is_the_tree(self):
        named, there = folders_of(page, root), folders_in(root)
        self.assertEqual(there - named, set())
        self.assertEqual([name for name in named if not (root / name).is_dir()], [])

    def test_page_is_two_pages(self):
        self.assertLessEqual(len(page.splitlines()), 120)
        self.assertEqual([line for line in page.splitlines() if len(line) > 140], [])

    def test_what_it_names_exists(self):
        self.assertEqual(unknown_paths(page), [])


class Decisions(unittest.TestCase):
    def test_are_numbered_dated_and_whole(self):
        for number, path in enumerate(decisions, 1):
            text = path.read_text()
            self.assertEqual(path.name.split("_")[0], f"{number:02d}")
            self.assertRegex(text, rf"\A# {number}\. .+\n\n\d{{4}}-\d\d-\d\d\n\n\*\*Context\.\*\* ")
            self.assertEqual(re.findall(r"^\*\*(\w+)\.\*\*", text, re.M),
                             ["Context", "Decision", "Measured", "Consequence"], path.name)

    def test_are_listed(self):
        index = (root / "docs/decisions/index.md").read_text()
        listed = sorted(re.findall(r"^- \[(.+)\]\((\w+\.md)\), ([\d-]+)$", index, re.M), key=lambda entry: number_of(entry[1]))
        there = [(*re.match(r"# (.+)\n\n(.+)\n", path.read_text()).groups(), path.name) for path in decisions]
        self.assertEqual(listed, [(title, name, date) for title, date, name in there])
        self.assertEqual(re.search(r"maxdepth: 1\n(.*)\n```", index, re.S)[1].split(),
                         [path.stem for path in decisions])

    def test_name_what_exists(self):
        tests = "".join(path.read_text() for path in (root / "tests").rglob("*.cpp"))
        for path in decisions:
            text = path.read_text()
            self.assertEqual(unknown_paths(text), [], path.name)
            for suite, name in re.findall(r"`([A-Z]\w+)\.([A-Z]\w+)`", text):
                known = re.search(rf"TEST\w*\({suite}, {name}\)", tests) or suite == "Documentation"
                self.assertTrue(known, f"{path.name}: {suite}.{name}")


class BrokenArchitecture(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.top = pathlib.Path(folder.name)
        for layer in architecture.layers:
            (self.top / layer).mkdir()

    def test_an_upward_include(self):
        (self.top / "core/a.hpp").write_text("#include <lagroid/run/run.hpp>\n")
        (self.top / "run/b.hpp").write_text("#include <lagroid/core/a.hpp>\n")
        edges = architecture.includes(self.top)
        self.assertEqual(edges, {("core", "run"), ("run", "core")})
        self.assertEqual(architecture.upward(edges), [("core", "run")])
        self.assertEqual(architecture.upward({("python", "app")}), [("python", "app")])

    def test_two_types_of_one_name(self):
        for file in ("core/a.hpp", "run/b.cpp"):
            (self.top / file).write_text("namespace lagroid {\n\nstruct Number {\n};\n\n}  // namespace lagroid\n")
        (self.top / "run/c.cpp").write_text("namespace lagroid {\nnamespace {\nstruct Number {\n};\n}  // namespace\n}\n")
        self.assertEqual(types_of_one_name(self.top), {"lagroid::Number": {"core/a.hpp", "run/b.cpp"}})

    def test_a_type_that_hides_another(self):
        (self.top / "core/a.hpp").write_text("namespace lagroid {\ntemplate <class S> class Step {\n};\n}  // namespace\n")
        (self.top / "run/b.hpp").write_text("namespace lagroid {\nnamespace detail {\nstruct Step {\n};\n}  // namespace\n}\n")
        self.assertEqual(types_of_one_name(self.top), {"lagroid::Step": {"core/a.hpp", "run/b.hpp"}})

    def test_an_edge_that_is_not_drawn(self):
        drawn = architecture.picture.read_text().replace("<title>run&#45;&gt;core</title>", "")
        self.assertEqual(architecture.includes() - architecture.shown(drawn), {("run", "core")})

    def test_a_folder_that_is_not_listed(self):
        (self.top / "solvers/annealing").mkdir()
        listed = "\n## Folders\n\n" + "".join(f"- `{layer}/`: all\n" for layer in architecture.layers)
        self.assertEqual(folders_in(self.top) - folders_of(listed, self.top), {"solvers/annealing"})

    def test_a_path_to_nothing(self):
        self.assertEqual(unknown_paths("`core/none.hpp`, `core/system.hpp`, `run/motion/`"), ["core/none.hpp"])

    def test_what_longer_ways_imply(self):
        self.assertEqual(architecture.implied({("c", "b"), ("b", "a"), ("c", "a")}), {("c", "a")})


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])
