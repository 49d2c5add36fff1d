"""The tables of keys in docs/scenes.md, from what `lagroid schema` says: scene_keys.py PROGRAM writes them, and
scene_keys.py PROGRAM --check says where they differ.

A table stands between <!-- keys of KIND: PATH --> and <!-- end of keys -->. KIND is what `lagroid schema` takes; after it
may stand `with KEY`, for those of its scenes that have the key.
"""
import json
import pathlib
import re
import subprocess
import sys

page = pathlib.Path(__file__).resolve().parents[1] / "scenes.md"
marks = re.compile(r"(<!-- keys of (\w+)(?: with (\w+))?: ([\w.]+) -->\n)(.*?)(<!-- end of keys -->)", re.DOTALL)


def number(x):
    return f"{x:,}".replace(",", " ") if isinstance(x, int) else f"{x:g}"


def range_of(declared):
    """The bounds of a number in words; nothing where there are none."""
    if declared.get("exclusiveMinimum") == 0 and "maximum" not in declared and "exclusiveMaximum" not in declared:
        return "> 0"
    bounds = [f"{sign} {number(declared[key])}" for key, sign in (("minimum", ">="), ("exclusiveMinimum", ">"),
                                                                  ("maximum", "<="), ("exclusiveMaximum", "<"))
              if key in declared]
    return ", ".join(bounds)


def value(declared):
    """What may stand there."""
    if "const" in declared:
        return f"`{declared['const']}`"
    if "enum" in declared:
        return ", ".join(f"`{word}`" for word in declared["enum"])
    if "anyOf" in declared:
        return " or ".join(value(each) for each in declared["anyOf"])
    kind = declared.get("type", "object")
    if kind == "array":
        items = declared["items"]
        least, most = declared["minItems"], declared.get("maxItems")
        if items.get("type") == "array":
            return f"{'' if most is None else f'{most} '}points of {items['minItems']} numbers"
        what = {"number": "numbers", "string": "strings"}.get(items.get("type"), "tables")
        count = "" if most is None else f"{least} " if least == most else f"{least} or {most} "
        return " ".join(f"{count}{what} {range_of(items)}".split())
    words = {"number": "number", "integer": "whole number", "string": "string", "boolean": "`true` or `false`",
             "object": "table"}
    return f"{words[kind]} {range_of(declared)}".strip()


def default(declared, required):
    """What holds without the key, and its meaning without that."""
    meaning, _, said = declared.get("description", "").partition(" (default: ")
    if said:
        return said.removesuffix(")"), meaning
    if required or "default" not in declared:
        return "", meaning
    given = declared["default"]
    return f"`{given}`" if isinstance(given, str) else json.dumps(given), meaning


def cell(text):
    return text.replace("|", "\\|")


def rows_of_keys(table):
    yield "| key | what stands there | default | meaning |"
    yield "|---|---|---|---|"
    for key, declared in table["properties"].items():
        otherwise, meaning = default(declared, key in table.get("required", []))
        yield "| " + " | ".join(map(cell, (f"`{key}`", value(declared), otherwise, meaning))) + " |"


def name_of_kinds(kinds):
    """The key that says of which kind a table is; nothing where there are no kinds."""
    for key, declared in kinds[0]["properties"].items():
        words = [kind["properties"].get(key, {}).get("const") for kind in kinds]
        if None not in words and len(set(words)) == len(kinds) > 1:
            return key
    return None


def rows_of_kinds(name, kinds):
    """A row for every kind. What a key means is said once."""
    yield f"| `{name}` | keys |"
    yield "|---|---|"
    told = []
    for kind in kinds:
        said = []
        for key, declared in kind["properties"].items():
            if key == name:
                continue
            if (key, declared) in told:
                said.append(f"`{key}`")
                continue
            told.append((key, declared))
            otherwise, meaning = default(declared, key in kind.get("required", []))
            said.append(f"`{key}`: {meaning}" + (f" (default {otherwise})" if otherwise else ""))
        title = kind["properties"][name]["const"]
        yield "| " + " | ".join(map(cell, (f"`{title}`: {kind['title']}", "; ".join(said)))) + " |"


def tables(declared):
    """All tables of which one holds."""
    return [found for each in declared["oneOf"] for found in tables(each)] if "oneOf" in declared else [declared]


def written(program, kind, with_key, path):
    declared = json.loads(subprocess.run([program, "schema", kind], capture_output=True, text=True, check=True).stdout)
    found = [table for table in tables(declared) if not with_key or with_key in table["properties"]]
    for step in filter(None, path.split(".")):
        below = [table["properties"][step] for table in found if step in table["properties"]]
        found = tables(below[0].get("items", below[0]))
    name = name_of_kinds(found)
    return "\n".join(rows_of_kinds(name, found) if name else rows_of_keys(found[0])) + "\n"


def main(program, *options):
    text = page.read_text()
    new = marks.sub(lambda at: at[1] + written(program, at[2], at[3], at[4]) + at[6], text)
    if options == ("--check",):
        if new != text:
            sys.exit("docs/scenes.md: the tables of keys are not those of `lagroid schema`: ./lagroid pages scenes")
        if len(marks.findall(text)) < 10:
            sys.exit("docs/scenes.md: fewer than ten tables of keys are between marks")
    else:
        page.write_text(new)


if __name__ == "__main__":
    main(*sys.argv[1:])
