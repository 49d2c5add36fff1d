"""Every lesson has its parts, and its scene ends with the verdicts that its table states, by each of its methods: lessons.py PROGRAM"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from pages import Page, root

sys.path.insert(0, str(root / "docs/site"))
program = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else root / "build/release/bin/lagroid").resolve()
folder = root / "docs/lessons"
parts = [r"\*\*Question\.\*\* ", r"\[Laboratory: ", "## Try\n", "## What is seen\n", "## Why\n", r"\$\$ ", "## Exercise\n",
         r"\*\*Answer\.\*\* "]
laboratory = re.compile(r"^\[Laboratory: [^],]+(?:, beside (\S+))?\]\((scenes/\w+\.toml)\)$", re.M)


def lessons():
    return [Page(path, path.read_text()) for path in sorted(folder.glob("[0-9]*.md"))]


def parts_missing(text):
    """What a lesson lacks, or has elsewhere than behind the part before."""
    at = 0
    for part in parts:
        found = re.compile(part).search(text, at)
        if not found:
            yield part
        else:
            at = found.end()
    if len(laboratory.findall(text)) != 1:
        yield "one laboratory"


def verdicts_stated(text):
    """{column: {quantity: verdict}} of the table whose first column is "quantity"."""
    rows = [[cell.strip() for cell in line.strip("|").split("|")]
            for line in re.search(r"^\| quantity .*(?:\n\|.*)+", text, re.M)[0].splitlines()]
    header, _, *body = rows
    return {column: {row[0]: row[i] for row in body} for i, column in enumerate(header) if i > 0}


def settings_of(scene, method):
    """What [time] holds for that method, as `lagroid study --list` says it."""
    listed = subprocess.run([program, "study", scene, "--list"], capture_output=True, text=True, check=True).stdout
    line = next(line for line in listed.splitlines() if line.split()[:1] == [method])
    return [f"time.{key}={value}" for key, value in re.findall(r"(\w+) = (\"[^\"]*\"|[^,]+)", line)]


def summary(scene, settings=()):
    words = [word for setting in settings for word in ("--set", setting)]
    with tempfile.TemporaryDirectory() as out:
        subprocess.run([program, "run", scene, *words, "--out", f"{out}/run"], capture_output=True, check=False)
        return json.loads((pathlib.Path(out) / "run/summary.json").read_text())


def verdicts(summary):
    return {entry["name"]: entry["verdict"] for entry in summary["ledger"]["entries"]}


def methods_of(page):
    """(column of the table, scene, settings) of each method of the laboratory."""
    second, path = laboratory.search(page.text).groups()
    scene = folder / path
    yield "of the scene", scene, []
    if second:
        yield second, scene, settings_of(scene, second)


class Lessons(unittest.TestCase):
    def test_are_twelve_with_all_their_parts(self):
        self.assertEqual(len(lessons()), 12)
        self.assertEqual([(page.name, part) for page in lessons() for part in parts_missing(page.text)], [])

    def test_lead_from_one_to_the_next(self):
        names = [page.path.name for page in lessons()]
        self.assertEqual(re.findall(r"^\| \d+\. \[.*?\]\((.*?)\)", (folder / "index.md").read_text(), re.M), names)
        following = [re.findall(r"\((\S+\.md)\)\n$", page.text)[0] for page in lessons()]
        self.assertEqual(following, [*names[1:], "index.md"])

    def test_verdicts_are_those_that_are_stated(self):
        for page in lessons():
            stated = verdicts_stated(page.text)
            methods = list(methods_of(page))
            with self.subTest(page.name):
                self.assertEqual(list(stated), [column for column, *_ in methods])
                for column, scene, settings in methods:
                    self.assertEqual(stated[column], verdicts(summary(scene, settings)), column)

    def test_scenes_are_spoken_of(self):
        text = "".join(page.text for page in lessons())
        self.assertEqual([path.name for path in folder.glob("scenes/*") if f"scenes/{path.name}" not in text], [])

    def test_addresses_hold_scene_and_methods(self):
        node = """import { read } from "%s/web/page/link.js"; console.log(JSON.stringify(read(process.argv[1])));""" % root
        try:
            from laboratory import fragment
            address = fragment('a = "é"', ["time.step=0.1"], "runge-kutta")
            done = subprocess.run(["node", "--input-type=module", "-e", node, address], capture_output=True, text=True, check=True)
        except (ImportError, FileNotFoundError) as missing:
            self.skipTest(str(missing))
        self.assertEqual(json.loads(done.stdout), {"scene": 'a = "é"', "settings": [["time.step", "0.1"]], "first": "",
                                                  "second": "runge-kutta", "fair": False, "views": []})


class BrokenLessons(unittest.TestCase):
    def test_without_an_answer(self):
        text = lessons()[0].text
        self.assertEqual(list(parts_missing(text)), [])
        self.assertEqual(list(parts_missing(text.replace("**Answer.**", ""))), [parts[-1]])
        self.assertEqual(list(parts_missing(text.replace("[Laboratory: ", "[Scene: "))), [parts[1], "one laboratory"])

    def test_with_another_verdict(self):
        page = lessons()[0]
        stated = verdicts_stated(page.text.replace("| energy | bounded | growing |", "| energy | bounded | bounded |"))
        column, scene, settings = list(methods_of(page))[1]
        self.assertNotEqual(stated[column], verdicts(summary(scene, settings)))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
