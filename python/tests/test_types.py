"""The stubs say what the module has, and the package, notebooks and tests keep to them."""

import ast
import re
import subprocess
import sys
import tempfile
import unittest
from importlib import util
from pathlib import Path

import lagroid
import stubs
from data import NOTEBOOKS, ROOT, code_of
from lagroid import _lagroid, compat


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

    def test_parameters_have_types(self) -> None:
        sound = self.mypy("-c", "import lagroid\nlagroid.Kepler(h=0.1, strength=2, quadrature='midpoint')")
        self.assertEqual(sound.returncode, 0, sound.stdout + sound.stderr)
        for wrong, why in (("mass=1.0", 'keyword argument "mass"'), ("quadrature='simpson'", "Literal['simpson']")):
            found = self.mypy("-c", f"import lagroid\nlagroid.Kepler({wrong})")
            self.assertEqual(found.returncode, 1, found.stderr)
            self.assertIn(why, found.stdout)


def keywords(function: ast.FunctionDef) -> dict[str, str]:
    """The parameters of a function with their defaults, "" where there is none; self apart."""
    given = function.args
    named = [*given.posonlyargs, *given.args]
    without = len(named) - len(given.defaults)
    defaults: list[ast.expr | None] = [*[None] * without, *given.defaults, *given.kw_defaults]
    all_of_them = zip([*named, *given.kwonlyargs], defaults)
    return {each.arg: ast.unparse(value) if value else "" for each, value in all_of_them if each.arg != "self"}


def signature(function: object) -> ast.FunctionDef:
    """That which pybind11 writes at the head of the docstring."""
    (parsed,) = ast.parse(f"def {(function.__doc__ or '').splitlines()[0]}: ...").body
    assert isinstance(parsed, ast.FunctionDef)
    return parsed


class Names(unittest.TestCase):
    """One name for one thing in C++, scenes and Python."""

    #: Public classes that are not C++'s, and why.
    OWN = {
        "Error": "the base of exceptions, which C++ takes from the standard library",
        "Interrupted": "Python's own way to end a computation",
        "Optimum": "optimisation::Result, in a package without namespaces",
        "ProgramError": "of programs that Python starts",
        "PrototypeIntegrator": "written in Python",
        "PrototypeTrajectory": "written in Python",
        "SolveError": "C++ returns a status",
        "Sweep": "what the program's command leaves in its folder",
    }

    def test_classes_have_the_names_of_cpp(self) -> None:
        folders = ("core", "groupoids", "solvers", "systems", "run", "app")
        headers = "\n".join(file.read_text() for each in folders for file in (ROOT / each).rglob("*.hpp"))
        declared = set(re.findall(r"^(?:template <.*> )?(?:struct|class|concept|using) (\w+)", headers, re.M))
        public = {name for name in lagroid.__all__ if name[0].isupper()}
        self.assertGreater(len(public), 40)
        self.assertEqual(public - declared, set(self.OWN))
        self.assertEqual({old for old in compat.NAMES if old in public}, set())

    def test_keywords_of_integrators_are_keys_of_scenes(self) -> None:
        page = (ROOT / "docs" / "scenes.md").read_text()
        tables = re.findall(r"<!-- keys of kepler with initial: (?:time|solver) -->\n(.*?)<!--", page, re.S)
        keys = set(re.findall(r"^\| `(\w+)` \|", "".join(tables), re.M))
        keys |= set(re.findall(r"A driven_pendulum has `(\w+)`", page))
        of_the_state = {"momentum", "object", "configuration", "ledger"}
        asked = set(keywords(signature(lagroid.Kepler.integrator))) - of_the_state
        self.assertLessEqual(asked, keys)

    def test_retired_names_are_told(self) -> None:
        for old, new in compat.NAMES.items():
            with self.assertWarnsRegex(DeprecationWarning, f"^lagroid.{old} is lagroid.{new}$") as told:
                self.assertIs(getattr(lagroid, old), getattr(lagroid, new))
            self.assertEqual(told.filename, __file__)
            self.assertNotIn(old, lagroid.__all__)
        with self.assertRaises(AttributeError):
            getattr(lagroid, "Walk")  # noqa: B009

    def test_retired_methods_are_told(self) -> None:
        class Old:
            """A groupoid as 0.2 wrote them."""

            dimension = 1

            def unit(self, q: lagroid.groupoids.Array) -> lagroid.groupoids.Arrow:
                return (q, q)

            def target(self, g: lagroid.groupoids.Arrow) -> lagroid.groupoids.Array:
                return g[1]

            def multiply(self, g: lagroid.groupoids.Arrow, h: lagroid.groupoids.Arrow) -> lagroid.groupoids.Arrow:
                return (g[0], h[1])

            def displaced(
                self, g: lagroid.groupoids.Arrow, v: lagroid.groupoids.Array, w: lagroid.groupoids.Array
            ) -> lagroid.groupoids.Arrow:
                return (g[0] + v, g[1] + w)

        class Free(lagroid.System):
            groupoid: lagroid.Groupoid = lagroid.Pair(1)

            def lagrangian(self, q0: lagroid.groupoids.Array, q1: lagroid.groupoids.Array) -> float:
                return (q1 - q0) @ (q1 - q0) / (2 * self.h)  # type: ignore[no-any-return]

        start = {"momentum": [1.0], "object": [0.0]}
        with self.assertWarnsRegex(DeprecationWarning, r"^Old.displaced\(g, v, w\) is translate\(v, g, w\)$"):
            old = Free(groupoid=Old()).integrator(**start)
        with self.assertWarnsRegex(DeprecationWarning, "^PrototypeIntegrator.march is PrototypeIntegrator.integrate$"):
            marched = old.march(10)  # type: ignore[attr-defined]
        new = Free().integrator(**start).integrate(10)
        self.assertLess(abs(marched.object - new.object).max(), 1e-14)
        compiled = lagroid.Pendulum().integrator(**start)
        with self.assertWarnsRegex(DeprecationWarning, "^Integrator.march is Integrator.integrate$"):
            self.assertEqual(compiled.march(3).steps, 3)


class Stubs(unittest.TestCase):
    def setUp(self) -> None:
        self.stub = ast.parse(stubs.STUB.read_text())

    def test_systems_are_as_they_are_declared(self) -> None:
        written = stubs.STUB.read_text()
        self.assertEqual(written, stubs.with_systems(written), "write it: ./lagroid pages stubs")
        self.assertEqual(stubs.with_systems(written.replace('"midpoint"', '"middle"')), written)

    def test_functions_have_the_keywords_of_their_stubs(self) -> None:
        compared = 0
        for scope, nodes in [(_lagroid, self.stub.body)] + [
            (getattr(_lagroid, node.name), node.body)
            for node in self.stub.body
            if isinstance(node, ast.ClassDef) and hasattr(_lagroid, node.name)
        ]:
            for node in nodes:
                if not isinstance(node, ast.FunctionDef) or node.name.startswith("__"):
                    continue
                value = getattr(scope, node.name)
                if callable(value):
                    self.assertEqual(keywords(node), keywords(signature(value)), f"{scope.__name__}.{node.name}")
                    compared += 1
        self.assertGreater(compared, 20)

    def test_every_system_has_the_keywords_of_their_base(self) -> None:
        bases = [node for node in self.stub.body if isinstance(node, ast.ClassDef) and node.name.startswith("_")]
        functions = {item.name: item for base in bases for item in base.body if isinstance(item, ast.FunctionDef)}
        for name in ("integrator", "boundary"):
            # A momentum that is not given is refused in words of ours.
            expected = {key: value or "None" for key, value in keywords(functions[name]).items()}
            found = keywords(signature(getattr(lagroid.Kepler, name)))
            self.assertEqual(expected, {key: value or "None" for key, value in found.items()})

    def test_every_name_has_its_stub(self) -> None:
        classes = {node.name: node for node in self.stub.body if isinstance(node, ast.ClassDef)}
        functions = {node.name for node in self.stub.body if isinstance(node, ast.FunctionDef)}
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
