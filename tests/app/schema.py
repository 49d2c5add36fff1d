#!/usr/bin/env python3
"""The schema that `lagroid schema` writes, beside the reader: schema.py PROGRAM EXAMPLES.

What the reader takes fits, what does not fit the reader refuses, and a key that the reader knows is in the schema.
"""
import copy
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib
import unittest

import jsonschema

program, examples = (pathlib.Path(word).resolve() for word in sys.argv[1:3])


def run(*words):
    return subprocess.run([str(program), *map(str, words)], capture_output=True, text=True, timeout=300)


def run_with(scene, setting):
    """A run of the scene with another value, into a folder of its own: a sweep asks for one before it is read."""
    with tempfile.TemporaryDirectory() as out:
        return run("run", scene, "--out", out, "--set", setting)


def schema(*kind):
    told = run("schema", *kind)
    assert told.returncode == 0, told.stderr
    return json.loads(told.stdout)


def fits(value, declared):
    return jsonschema.Draft202012Validator(declared).is_valid(value)


def table_for(value, declared):
    """The one of the kinds that the value is of."""
    if "oneOf" not in declared:
        return declared
    return next((found for kind in declared["oneOf"] if (found := table_for(value, kind)) and fits(value, found)), None)


def tables_of(value, declared, path=""):
    """Every table of a scene that is there or may be, as path, value and schema."""
    declared = table_for(value, declared)
    yield path, value, declared
    for key, below in declared["properties"].items():
        if below.get("type") == "array" and isinstance(value.get(key), list):
            for i, each in enumerate(value[key]):
                if isinstance(each, dict):
                    yield from tables_of(each, below["items"], f"{path}{key}.{i}.")
        elif "properties" in below or "oneOf" in below:
            there = value.get(key, {})
            if key in value or fits({}, below):
                yield from tables_of(there, below, f"{path}{key}.")


def with_value(scene, path, value):
    """The scene with another value at a path."""
    out = copy.deepcopy(scene)
    *way, last = path.split(".")
    at = out
    for step in way:
        at = at[int(step)] if isinstance(at, list) else at.setdefault(step, {})
    at[last] = value
    return out


def beyond(declared, there):
    """Values that the schema of a key refuses, each with what is wrong with it."""
    yield "of another type", {}
    if declared.get("type") in ("number", "integer"):
        for bound, step in (("minimum", -1), ("maximum", 1)):
            if bound in declared:
                limit = declared[bound]
                yield f"beyond the {bound}", limit + step * max(1, abs(limit) / 4)
            if (exclusive := f"exclusive{bound.capitalize()}") in declared:
                yield f"at the {exclusive}", declared[exclusive]
    if "enum" in declared or "const" in declared:
        yield "no such word", "no-such-word"
    if declared.get("type") == "array" and declared.get("minItems") == declared.get("maxItems") and there:
        yield "of another dimension", there + there[:1]


def of_kind(path, declared):
    """What tables and keys of one kind share: the same of the first body and of the second is asked once."""
    return re.sub(r"\d+", "0", path), json.dumps(declared, sort_keys=True)


scenes = sorted(examples.rglob("*.toml"))


#: Keys that are read or not by what else stands there, which no schema tells: where a joint has an end on the ground,
#: where a spring's bodies turn in space.
DEPENDENT = {"ground_amplitude", "ground_rate", "direction"}


class Schema(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.whole = schema()
        cls.refusals = {}

    def refusal(self, scene, path, value):
        """The one line in which the reader refuses the value, or none."""
        told = run_with(scene, f"{path}={json.dumps(value)}")
        return told.stderr if told.returncode == 2 and told.stderr.count("\n") == 1 else None

    def refused(self, scene, path, value):
        return self.refusal(scene, path, value) is not None

    def known(self, scene, path):
        """The keys that the reader knows in a table, as it lists them where it refuses another."""
        told = run_with(scene, f"{path}zzzzzzzzzzzzzzzzzzzzzzzz=1")
        found = told.stderr.strip().partition("unknown key; known here: ")[2]
        self.assertEqual((told.returncode, bool(found)), (2, True), f"{scene}: {path}: {told.stderr}")
        return set(found.split(", "))

    def test_is_one_of_its_draft(self):
        self.assertEqual(self.whole["$schema"], "https://json-schema.org/draft/2020-12/schema")
        jsonschema.Draft202012Validator.check_schema(self.whole)

    def test_every_example_fits(self):
        self.assertGreater(len(scenes), 45)
        for scene in scenes:
            told = jsonschema.Draft202012Validator(self.whole).iter_errors(tomllib.loads(scene.read_text()))
            self.assertEqual([jsonschema.exceptions.best_match([error]).message for error in told], [], str(scene))

    def never_taken(self, scene, path, key, declared):
        """Whether the reader knows a key only to say why it cannot stand there, as it does if it refuses a number and a
        word with the same words: asked once of all tables that are alike."""
        alike = of_kind(key, declared)
        if alike not in self.refusals:
            words = {self.refusal(scene, path + key, each) for each in (0.5, "x")}
            self.refusals[alike] = None not in words and (len(words) == 1 or all(
                self.refused(scene, path + key, each) for each in (1, True, [0.5, 1, 2], {})))
        return self.refusals[alike]

    def differences(self, scene, path, declared):
        """The keys of a table that only the reader knows, and those that only the schema has."""
        known, there = self.known(scene, path), set(declared["properties"])
        return {key for key in known - there if not self.never_taken(scene, path, key, declared)}, there - known

    def test_every_key_that_the_reader_knows_is_there(self):
        dependent_and_read, asked = set(), set()
        for scene in scenes:
            for path, value, declared in tables_of(tomllib.loads(scene.read_text()), self.whole):
                alike = (*of_kind(path, declared), frozenset(value))
                if alike in asked:
                    continue
                asked.add(alike)
                with self.subTest(scene=scene.name, path=path):
                    missing, unread = self.differences(scene, path, declared)
                    self.assertEqual((missing, unread - DEPENDENT), (set(), set()))
                    dependent_and_read |= DEPENDENT & set(declared["properties"]) - unread
        self.assertEqual(dependent_and_read, DEPENDENT)

    def test_a_broken_schema_is_found_out(self):
        scene = examples / "kepler.toml"
        content = tomllib.loads(scene.read_text())
        broken = copy.deepcopy(table_for(content, self.whole))
        parameters = broken["properties"]["parameters"]
        key = next(iter(content["parameters"]))
        declared = parameters["properties"].pop(key)
        parameters["properties"]["colour"] = {"type": "string"}
        self.assertFalse(fits(content, broken))
        self.assertEqual(self.differences(scene, "parameters.", parameters), ({key}, {"colour"}))
        # Bounds that the reader has not.
        declared["maximum"] = 2
        self.assertFalse(all(self.refused(scene, f"parameters.{key}", value) for _, value in beyond(declared, None)))

    def test_what_does_not_fit_is_refused(self):
        asked = set()
        for scene in scenes:
            content = tomllib.loads(scene.read_text())
            for path, there, table in tables_of(content, self.whole):
                for key, declared in table["properties"].items():
                    alike = of_kind(path + key, declared)
                    if alike in asked:
                        continue
                    asked.add(alike)
                    for what, value in beyond(declared, there.get(key)):
                        bad = with_value(content, path + key, value)
                        if fits(value, declared):  # as an empty table may, or one of several values
                            continue
                        self.assertFalse(fits(bad, self.whole), f"{scene}: {path}{key} = {value}, {what}")
                        self.assertTrue(self.refused(scene, path + key, value), f"{scene}: {path}{key} = {value}, {what}")
        self.assertGreater(len(asked), 200)

    def test_scenes_that_are_wrong(self):
        for name, path, value in (
                ("kepler", "parameters.strenght", 1), ("kepler", "initial.position", [1, 0, 0]),
                ("kepler", "initial.position", "1 m"), ("kepler", "time.step", -0.1), ("kepler", "time.step", "0.1 s"),
                ("kepler", "time.steps", 0), ("kepler", "time.mode", "adaptiv"), ("rigid_body", "parameters.inertia", 1),
                ("rigid_body", "parameters.inertia", [1, 2, -3]), ("tops", "body.0.colour", "red"),
                ("tops", "body.0.kind", "rigidd"), ("tops", "joint.0.points", [[0, 0], [0, 0]]),
                ("six_bar", "solver.tolerance", 0.01), ("plate_ball", "boundary.end.position", [1]),
                ("pendulum_chain", "parameters.masses", []), ("optimisation/rayleigh", "method.name", "newton"),
                ("sweeps/kepler", "design.kind", "lattice")):
            scene = examples / f"{name}.toml"
            bad = with_value(tomllib.loads(scene.read_text()), path, value)
            self.assertFalse(fits(bad, self.whole), f"{name}: {path} = {value}")
            self.assertTrue(self.refused(scene, path, value), f"{name}: {path} = {value}")

    def test_one_kind_alone(self):
        kepler = tomllib.loads((examples / "kepler.toml").read_text())
        self.assertTrue(fits(kepler, schema("kepler")))
        self.assertFalse(fits(kepler, schema("bodies")))
        told = run("schema", "keppler")
        self.assertEqual((told.returncode, told.stdout, told.stderr.count("\n")), (2, "", 1))
        self.assertIn("keppler", told.stderr)
        self.assertIn("kepler, ", told.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
