"""CITATION.cff is YAML with what version 1.2.0 of the Citation File Format requires: citation.py FILE"""
import re
import sys

import yaml


def mistakes(citation):
    """What is wrong with a citation, in words."""
    out = [f"no {key}" for key in ("cff-version", "message", "title", "authors") if not citation.get(key)]
    if citation.get("cff-version") != "1.2.0":
        out.append("cff-version is not 1.2.0")
    if citation.get("type", "software") not in ("software", "dataset"):
        out.append("type is neither software nor dataset")
    for author in citation.get("authors") or []:
        if not (author.get("name") or author.get("family-names")):
            out.append(f"author without a name: {author}")
    for reference in citation.get("references") or []:
        named = reference.get("title", "a reference without title")
        out += [f"{named}: no {key}" for key in ("type", "title", "authors", "journal", "year", "doi") if not reference.get(key)]
        if not re.fullmatch(r"10\.\d{4,}(\.\d+)*/\S+", str(reference.get("doi"))):
            out.append(f"{named}: no DOI: {reference.get('doi')}")
        if not isinstance(reference.get("year"), int):
            out.append(f"{named}: the year is no number")
    return out


with open(sys.argv[1], encoding="utf-8") as file:
    found = yaml.safe_load(file)
wrong = mistakes(found)
broken = dict(found, references=[dict(found["references"][0], doi="none", title="")], title="")
if len(mistakes(broken)) != 3:
    wrong.append(f"a broken file is not found out: {mistakes(broken)}")
print("\n".join(wrong) or "holds")
sys.exit(bool(wrong))
