#!/usr/bin/env python3
"""Names of files that are compiled together (CMAKE_UNITY_BUILD): files_together.py BUILD

What stands in anonymous namespaces of two files of one target meets as soon as a file more puts them into one batch. So a
name there is one thing in the whole target: functions may share one where their arguments tell them apart, and aliases
where they say the same.
"""
import collections
import itertools
import pathlib
import re
import sys
import tempfile
import unittest

build = pathlib.Path(sys.argv[1])
alias = re.compile(r"(?:using|namespace) (\w+) = ")
type_of_its_own = re.compile(r"(?:template ?<.*> )?(?:struct|class|enum class|enum) (\w+)\b(?!.*;$)")
function = re.compile(r"[\w:<>,&*\[\] .]*?[ &*>](\w+)\((.*)")
value = re.compile(r"[\w:<>,&*\[\] .]+ (\w+)(?:\[\d*\])?(?: =|\{|;)")
kinds = (alias, type_of_its_own, function, value)


def declared(file):
    """What anonymous namespaces of a file declare: (namespace, name), kind of thing, what tells it apart, file. The layout is
    clang-format's."""
    scope = []
    for line in file.read_text().splitlines():
        if opened := re.match(r"(?:inline )?namespace ([\w:]*) ?\{$", line):
            scope.append(opened[1])
        elif line.startswith("}  // namespace"):
            scope.pop()
        elif "" in scope and re.match(r"[A-Za-z]", line):
            kind, found = next(((kind, found) for kind in kinds if (found := kind.match(line))), (None, None))
            if found:
                yield ("::".join(scope), found[1]), kind, found[2] if kind is function else line, file


def meet(one, other):
    """Whether two things of one name cannot stand in one file."""
    (_, kind, tells, file), (_, other_kind, other_tells, other_file) = one, other
    if file == other_file:
        return False
    if kind is other_kind is function:
        return tells == other_tells
    return not (kind is other_kind is alias and tells == other_tells)


def twice(files):
    """Names that stand for two things, with the files."""
    things = collections.defaultdict(list)
    for file in files:
        for thing in declared(file):
            things[thing[0]].append(thing)
    for (_, name), alike in things.items():
        if any(meet(one, other) for one, other in itertools.combinations(alike, 2)):
            yield name, sorted({str(thing[3]) for thing in alike})


class Targets(unittest.TestCase):
    def test_have_one_meaning_for_each_name(self):
        files = collections.defaultdict(set)
        for batch in build.rglob("CMakeFiles/*.dir/Unity/*.cxx"):
            files[batch.parent.parent].update(map(pathlib.Path, re.findall(r'^#include "(.+)"$', batch.read_text(), re.M)))
        self.assertGreater(len(files), 50)
        self.assertEqual([(str(target.name), *found) for target, of_it in sorted(files.items()) for found in twice(of_it)], [])


class BrokenTargets(unittest.TestCase):
    def of(self, *texts):
        with tempfile.TemporaryDirectory() as name:
            files = [pathlib.Path(name) / f"{number}.cpp" for number in range(len(texts))]
            for file, text in zip(files, texts):
                file.write_text(f"namespace lagroid {{\n\nnamespace {{\n\n{text}\n\n}}  // namespace\n\n}}  // namespace lagroid\n")
            return [name for name, _ in twice(files)]

    def test_two_functions_of_the_same_arguments(self):
        self.assertEqual(self.of("int size(double x) {", "double size(double x) {"), ["size"])
        self.assertEqual(self.of("int size(double x) {", "int size(int x) {"), [])

    def test_two_values(self):
        self.assertEqual(self.of("constexpr double small = 1e-12;", "constexpr double small = 1e-13;"), ["small"])
        self.assertEqual(self.of("constexpr double small = 1e-12;", "constexpr double tiny = 1e-13;"), [])

    def test_a_value_and_a_function(self):
        self.assertEqual(self.of("constexpr int pages[] = {1};", "int pages(int n) {"), ["pages"])

    def test_two_types(self):
        self.assertEqual(self.of("struct Row {", "class Row final : public Line {"), ["Row"])

    def test_aliases_of_two_things(self):
        self.assertEqual(self.of("using Json = A;", "using Json = B;"), ["Json"])
        self.assertEqual(self.of("namespace fs = std::filesystem;", "namespace fs = std::filesystem;"), [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
