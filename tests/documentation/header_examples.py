"""The examples in the opening comments of public headers compile: header_examples.py COMPILER OPTION...

An example takes for granted that its reader has something to use it on. What that is stands in header_contexts.txt, a
section for each header that needs one: includes, and declarations that are never defined, since the compiler only
checks. `{ ... }` is a body left out; where an example consists of members, `@` in the section is where they go. There
is a translation unit for each entry of `units`, with the headers of all its examples.
"""
import dataclasses
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

root = pathlib.Path(__file__).resolve().parents[2]
units = ["core", "groupoids", "solvers/galerkin", "solvers/boundary solvers/ensemble solvers/step solvers/integrators solvers/methods",
         "solvers/generating solvers/learning solvers/lie_group solvers/linear_algebra solvers/newton "
         "solvers/optimisation solvers/poisson solvers/testing solvers/status.hpp",
         "solvers/control solvers/extrapolation solvers/sensitivity", "systems", "run"]
contexts_file = pathlib.Path(__file__).with_name("header_contexts.txt")
always = ["<lagroid/systems/kepler.hpp>", "<gtest/gtest.h>", "<cmath>", "<iostream>"]


@dataclasses.dataclass
class Example:
    header: str
    line: int
    code: str

    def at_namespace_scope(self):
        return re.match(r"(struct|class|template <|inline|LAGROID_)", self.code) is not None


def examples_of(text, header):
    """The indented blocks of the opening comment that are code: one of their lines ends like a statement or a body."""
    comment = re.match(r"#pragma once\n((?:///.*\n)*)", text)
    out = []
    for block in re.finditer(r"(?:^///     .*\n)+", comment[1] if comment else "", re.M):
        code = re.sub(r"^///     ", "", block[0], flags=re.M)
        if re.search(r"(;|[{}]) *(//.*)?$", code, re.M) and not re.search(r" o \.\.\. o ", code):
            out.append(Example(header, 2 + comment[1][:block.start()].count("\n"), code))
    return out


def headers_of(unit):
    for each in unit.split():
        path = root / each
        yield from [path] if path.is_file() else sorted(path.rglob("*.hpp"))


def contexts(text):
    """Of each header its section, which begins with its name in brackets."""
    parts = re.split(r"^\[(.+)\]\n", text, flags=re.M)
    return dict(zip(parts[1::2], parts[2::2]))


def unit_of(examples, given):
    """The translation unit of some examples, each in a namespace of its own; the compiler is told where they stand."""
    lines = {example.header: given.get(example.header, "").splitlines() for example in examples}
    out = [f"#include {header}" for header in [*always, *(f"<lagroid/{header}>" for header in lines)]]
    out += dict.fromkeys(line for context in lines.values() for line in context if line.startswith("#include"))
    for number, example in enumerate(examples):
        context = "\n".join(line for line in lines[example.header] if not line.startswith("#include"))
        code = f'#line {example.line} "{example.header}"\n{example.code.replace("{ ... }", "{}")}'
        out += [f"namespace example_{number} {{", "using namespace lagroid;"]
        if "@" in context:
            out.append(context.replace("@", "\n" + code + '#line 1 "context"\n'))
        else:
            out += ['#line 1 "context"', context]
            out.append(code if example.at_namespace_scope() else f"inline int run() {{\n{code}return 0;\n}}")
        out.append("}")
    return "\n".join(out) + "\n"


def refusals(source, compiler, options):
    """What the compiler says of it."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "examples.cpp"
        path.write_text(source)
        done = subprocess.run([compiler, "-std=c++20", "-fsyntax-only", "-w", *options, path],
                              capture_output=True, text=True)
        return "" if done.returncode == 0 else done.stderr


def compiled(source):
    """What the compiler of the build says of it; it comes with the command."""
    compiler, *options = sys.argv[1:]
    return refusals(source, compiler, options)


class Headers(unittest.TestCase):
    maxDiff = None

    def setUp(self):
        self.given = contexts(contexts_file.read_text())
        self.examples = {unit: [example for path in headers_of(unit)
                                for example in examples_of(path.read_text(), str(path.relative_to(root)))]
                         for unit in units}

    def test_all_layers_are_asked(self):
        self.assertGreater(sum(map(len, self.examples.values())), 220)
        asked = {str(path.relative_to(root)) for unit in units for path in headers_of(unit)}
        public = {str(path.relative_to(root)) for layer in ("core", "groupoids", "solvers", "systems", "run")
                  for path in (root / layer).rglob("*.hpp")}
        with_code = {name for name in public if examples_of((root / name).read_text(), name)}
        self.assertEqual(with_code - asked, set())

    def test_contexts_are_of_examples(self):
        self.assertEqual(set(self.given) - {e.header for unit in self.examples.values() for e in unit}, set())

    def test_examples_compile(self):
        for unit, examples in self.examples.items():
            with self.subTest(unit):
                self.assertEqual(compiled(unit_of(examples, self.given)), "")


class BrokenHeaders(unittest.TestCase):
    header = "core/scalars/dual.hpp"

    def of(self, code):
        block = "///     " + code.replace("\n", "\n///     ") + "\n"
        return examples_of(f"#pragma once\n/// What it is.\n///\n{block}///\n/// Throws nothing.\n", self.header)

    def test_a_formula_is_no_example(self):
        self.assertEqual(self.of("y = z tau(v)"), [])
        self.assertEqual([(e.line, e.code) for e in self.of("f(x);")], [(4, "f(x);\n")])

    def test_an_example_that_does_not_compile(self):
        examples = self.of("const Dual<double> x(2.0, 1.0);\nconst double y = x.slope;") + self.of("sin(unknown);")
        errors = re.findall(rf"{self.header}:(\d):\d+: error: (.*)", compiled(unit_of(examples, {})))
        self.assertEqual([line for line, _ in errors], ["5", "4"])
        self.assertIn("slope", errors[0][1])
        known = {self.header: "extern double known;"}
        self.assertEqual(compiled(unit_of(self.of("const double y = sin(known);"), known)), "")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])
