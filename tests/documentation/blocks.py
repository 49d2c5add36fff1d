"""Every block of code in the Markdown pages is compiled, run or read: blocks.py PROGRAM

- C++, CMake and Python are part of a file that CI compiles or runs; a comment of three dots leaves lines out. Python may also be
  that of a page which the module's tests run.
- TOML is a scene that the program runs, initial values for two steps, or a sweep, of two members along each axis; where it
  opens with `# examples/NAME.toml, with` its tables take the place of that scene's.
- Commands name subcommands, options and files that exist; those that take a moment are carried out.
- Text that follows commands is what they print, numbers to a thousandth, those below 1e-8 of that size; a line of three
  dots leaves lines out.
- Indented blocks are formulas, trees, output or commands, never code that none of this would ask.
"""
import functools
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import tomllib
import unittest

from pages import Block, Page, flush_left, pages, root

program = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else root / "build/release/bin/lagroid").resolve()
script = (root / "lagroid").read_text()
here = pathlib.Path(__file__).resolve().parent


def run(arguments, folder):
    return subprocess.run([program, *arguments], cwd=folder, capture_output=True, text=True, timeout=120)


# What is part of a file.

sources = {"cpp": ("*.cpp", "*.hpp"), "cmake": ("CMakeLists.txt", "*.cmake"), "python": ("*.py",)}


@functools.cache
def source(language):
    """The text of all files of that language which CI compiles or runs."""
    names = ("core", "groupoids", "solvers", "systems", "run", "examples", "tests", "python")
    folders = [root / name for name in names if (root / name).is_dir()]
    return "\n".join(flush_left(file.read_text()) for folder in folders for pattern in sources[language]
                     for file in sorted(folder.rglob(pattern)) if here not in file.parents)


def run_as_a_whole(page):
    """Whether the module's own test runs the Python of the page, from its first block to its last."""
    test = root / "python/tests/test_documentation.py"
    return test.exists() and f'"{pathlib.Path(page).name}"' in test.read_text()


def foreign(block):
    if block.language == "python" and run_as_a_whole(block.page):
        return
    for part in re.split(r"^ *(?://|#) \.\.\.\n", block.text, flags=re.M):
        if flush_left(part) not in source(block.language):
            yield f"{block}: {block.language} that is part of no file which CI compiles or runs:\n{part}"


# Scenes.

def command_for(tables):
    """What reads a file of these tables, for a moment."""
    if "problem" in tables:
        return ["optimize"]
    if "scene" in tables:
        return ["sweep", "--out", "out/sweep_of_a_page"]
    short = "steps" in tables.get("time", {}) and "boundary" not in tables
    return ["run", *(["--set", "time.steps=2"] if short else [])]


def scene_failures(block, folder):
    over = re.match(r"# (examples/\S+\.toml), with\b", block.text)
    text = merged((root / over[1]).read_text(), block.text) if over else block.text
    name, *options_of_it = command_for(tomllib.loads(text))
    place = pathlib.Path(over[1]).parent if over else "examples/sweeps" if name == "sweep" else "examples"
    path = folder / place / "block.toml"
    path.parent.mkdir(exist_ok=True)
    path.write_text(re.sub(r"^count *= *\d+", "count = 2", text, flags=re.M) if name == "sweep" else text)
    done = run([name, path, *options_of_it], folder)
    shutil.rmtree(folder / "out/sweep_of_a_page", ignore_errors=True)
    if done.returncode != 0:
        yield f"{block}: {(done.stderr or done.stdout).strip()}"


def merged(base, changes):
    """The scene `base`, with the tables of `changes` in the place of its own."""
    def tables(text):
        out = {}
        for part in re.split(r"^(?=\[)", text, flags=re.M):
            name = part.split("]")[0] if part.startswith("[") else ""
            out[name] = out.get(name, "") + part
        return out

    return "\n".join({**tables(base), **{name: text for name, text in tables(changes).items() if name}}.values())


# Commands.

def commands(text):
    """The command lines of a block that start lagroid: their words after the name."""
    joined = re.sub(r"\\\n", " ", text)
    for line in joined.splitlines():
        for found in re.finditer(r"(?:^|[;|&]|\bdo)\s*(?:\$ )?(?:(?:mpirun|srun) .*)?(?:\./)?\blagroid(?= )([^;|&]*)", line):
            words = re.split(r"\s#|\s\(|\s\[", found[1])[0]
            try:
                yield shlex.split(words)
            except ValueError:
                yield None


@functools.cache
def options(*path):
    """The options of a subcommand, such as ("run",) or ("reproduce", "time-steps"); None if there is no such one."""
    arm = re.search(rf"^  (?:\w+ \| )*{path[0]}(?: \| \w+)*\)(.*?)^    ;;", script, re.M | re.S)
    beside = {"check": ("check/check.cpp",), "gradient": ("gradient/gradient.cpp",),
              "fit": ("gradient/gradient.cpp", "gradient/fit/fit_command.cpp")}
    if path[0] in beside:  # take minutes to build: their options as their sources name them
        sources_of_it = (*beside[path[0]], "command/command.cpp")
        said = "".join((root / "app" / name).read_text() for name in sources_of_it)
        return set(re.findall(r"--[\w-]+", said))
    if arm and 'exec "$program" "$@"' not in arm[1]:  # else it is the program's
        mentions = re.findall(rf"^#.*lagroid {path[0]} .*", script, re.M)
        return set(re.findall(r"--[\w-]+", "\n".join([arm[1], *mentions])))
    said = run([*path, "--help"], root).stdout
    if f"Usage: {' '.join(['lagroid', *path])}" not in said:
        return None
    return set(re.findall(r"(?<![\w-])--[a-z][\w-]*", said))


def misused(words):
    """Why a command cannot be carried out as it stands; empty if it can."""
    if words is None:
        return "quotes that are not closed"
    if not words or words[0].startswith("--") or words[0].isupper() or "..." in words[0]:
        return ""  # a form, or an option of the program itself
    known = options(*words[:2]) if words[0] == "reproduce" and len(words) > 1 else options(words[0])
    if known is None:
        return f'no subcommand "{words[0]}"'
    unknown = [word for word in words[1:] if re.match(r"--[a-z]", word) and word.split("=")[0] not in known]
    if unknown:
        return f"{words[0]} has no option {unknown[0]}"
    named = [word for before, word in zip(words, words[1:])
             if before != "--out" and re.match(r"(examples|docs|tests|python)/", word)]
    missing = [word for word in named if not (root / word).exists()]
    return f"no file {missing[0]}" if missing else ""


# Networks of more than six units take their time.
slow = re.compile(r"network:([7-9]|\d\d)")
momentary = {"new", "run", "resume", "view", "plot", "list", "optimize", "trajectories", "learn", "cite"}


def examples_named(text):
    """The programs of examples/ that a block starts."""
    return [program.parent / name for name in re.findall(r"^\s*build/release/bin/(\w+)", text, re.M)]


def command_failures(block, folder, printed):
    """Adds to `printed` what those print that are carried out."""
    given = list(commands(block.text))
    for words in given:
        if why := misused(words):
            yield f"{block}: lagroid {' '.join(words or [])}: {why}"
            return
    if any(re.search(r"[$]|\.\.\.", word) or word.isupper() for words in given for word in words):
        return  # a form, not a command
    # What errors become is told by the program with derivatives, which takes minutes to build.
    waits = re.compile(slow.pattern + r"|--(deviations|covariance)")
    calls = [[program, *words] for words in given if words[0] in momentary and not waits.search(" ".join(words))]
    for call in calls + [[example] for example in examples_named(block.text)]:
        # Systems of one's own are compiled into a cache that goes with the folder.
        done = subprocess.run(call, cwd=folder, capture_output=True, text=True, timeout=600,
                              env={**os.environ, "XDG_CACHE_HOME": str(folder)})
        printed.append(done.stdout)
        if done.returncode != 0:
            yield f"{block}: {' '.join(map(str, call))}: {done.stderr.strip()}"


number = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def says(printed, line):
    """Whether it is one of the lines printed."""
    def alike(one, other):
        a, b = float(one), float(other)
        return abs(a - b) <= 1e-3 * max(abs(a), abs(b)) or max(abs(a), abs(b)) < 1e-8

    words, numbers = number.sub("#", " ".join(line.split())), number.findall(line)
    return any(number.sub("#", " ".join(other.split())) == words and all(map(alike, numbers, number.findall(other)))
               for other in printed.splitlines())


def quotation_failures(block, printed):
    for line in block.text.splitlines():
        if line.strip() not in ("", "...") and not says(printed, line):
            yield f"{block}: not printed: {line}"


# Pages.

def hidden(block):
    """Indented code that should stand between fences, where it would be asked."""
    if re.search(r"^\[\[?[a-z_.]+\]\]?$", block.text, re.M):
        yield f"{block}: TOML; write ```toml"
    elif re.search(r"[;{]$", block.text, re.M):
        yield f"{block}: C++; write ```cpp"
    elif re.search(r"^(import \w+|from \w+ import|>>> )", block.text, re.M):
        yield f"{block}: Python; write ```python"


languages = {"cpp", "cmake", "python", "toml", "sh", "text", "json", ""}


def failures(block, folder, printed):
    if block.language not in languages:
        yield f"{block}: blocks of {block.language} are asked nothing"
    if block.language in sources:
        yield from foreign(block)
    if block.language == "toml":
        yield from scene_failures(block, folder)
    if block.language in ("sh", ""):
        printed.clear()
        yield from command_failures(block, folder, printed)
    elif block.language == "text" and printed:
        yield from quotation_failures(block, "\n".join(printed))
    if block.language == "":
        yield from hidden(block)


def inline_failures(page):
    for line, token in page.inlines():
        if token.type == "code_inline" and re.match(r"(\./)?lagroid [a-z]", token.content):
            for words in commands(token.content):
                if why := misused(words):
                    yield f"{page.name}:{line}: `{token.content}`: {why}"


def furnish(folder):
    """Makes a folder in which commands find the scenes, and can leave their own beside them."""
    for file in (*(root / "examples").rglob("*"), *(root / "docs/lessons/scenes").iterdir()):
        if file.is_file():
            place = folder / file.relative_to(root)
            place.parent.mkdir(parents=True, exist_ok=True)
            place.symlink_to(file)


class Pages(unittest.TestCase):
    maxDiff = None

    def test_what_they_show_works(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            furnish(folder)
            found = []
            for page in pages():
                printed = []  # by the commands of the last block of them
                for block in page.blocks():
                    found += failures(block, folder, printed)
        self.assertEqual(found, [])

    def test_what_they_mention_exists(self):
        self.assertEqual([why for page in pages() for why in inline_failures(page)], [])


class Gallery(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        sys.path.insert(0, str(root / "docs/site"))

    def test_moving_picture_is_that_of_its_program(self):
        import motion

        drawn = motion.draw(*motion.nodes(program.parent / "figure_eight"))
        theirs, ours = ([float(word) for word in number.findall(text)] for text in (motion.picture.read_text(), drawn))
        self.assertEqual(len(theirs), len(ours), "draw it: ./lagroid pages gallery")
        self.assertLess(max(abs(a - b) for a, b in zip(theirs, ours)), 1, "draw it: ./lagroid pages gallery")

    def test_is_what_its_scenes_say(self):
        import gallery

        self.assertEqual((root / "docs/gallery.md").read_text(), gallery.page(), "write it: ./lagroid pages gallery")


class BrokenPages(unittest.TestCase):
    def of(self, language, text, printed=()):
        with tempfile.TemporaryDirectory() as name:
            furnish(pathlib.Path(name))
            return len(list(failures(Block("page.md", 1, language, text), pathlib.Path(name), list(printed))))

    def test_code_of_nowhere(self):
        self.assertEqual(self.of("cpp", "int none_of_ours;\n"), 1)
        self.assertEqual(self.of("python", "none_of_ours = 1\n"), 1)
        self.assertEqual(self.of("fortran", "end\n"), 1)

    def test_scenes_that_are_not_read(self):
        self.assertEqual(self.of("toml", 'system = "kepler"\n[parameters]\nno_such = 1\n'), 1)
        self.assertEqual(self.of("toml", "# examples/kepler.toml, with\n[time]\nno_such = 1\n"), 1)
        self.assertEqual(self.of("toml", "# examples/kepler.toml, with\n[time]\nstep = 0.1\nsteps = 5\n"), 0)

    def test_commands_that_are_none(self):
        self.assertEqual(self.of("", "./lagroid sprint examples/kepler.toml\n"), 1)
        self.assertEqual(self.of("", "./lagroid run examples/none.toml\n"), 1)
        self.assertEqual(self.of("", "./lagroid run examples/kepler.toml --no-such\n"), 1)
        self.assertEqual(self.of("", "./lagroid pages --no-such\n"), 1)
        self.assertEqual(self.of("sh", f"./lagroid run {root}/examples/kepler.toml --set time.no_such=1\n"), 1)

    def test_code_in_disguise(self):
        self.assertEqual(self.of("", "double h;\n"), 1)
        self.assertEqual(self.of("", "[time]\nstep = 1\n"), 1)

    def test_output_of_something_else(self):
        printed = ["energy   drift 3.71e-04: kept\n"]
        self.assertEqual(self.of("text", "energy drift 3.711e-04: kept\n...\n", printed), 0)
        self.assertEqual(self.of("text", "energy drift 3.72e-04: kept\n", printed), 1)
        self.assertEqual(self.of("text", "momentum drift 3.71e-04: kept\n", printed), 1)

    def test_mentions(self):
        page = Page(root / "page.md", "`lagroid sprint`, `./lagroid run --no-such`, `lagroid list`")
        self.assertEqual(len(list(inline_failures(page))), 2)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])
