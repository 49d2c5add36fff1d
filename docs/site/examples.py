"""Writes docs/examples.md: examples.py PROGRAMS runs the programs of examples/cpp, which lie in the folder PROGRAMS."""
import os
import pathlib
import re
import subprocess
import sys

root = pathlib.Path(__file__).resolve().parents[2]
sources = sorted((root / "examples/cpp").glob("*.cpp"))

opening = """# Ten examples, one a lesson

Each is a program of its own, short enough for one look: what it teaches and from which equation, the code, what it prints. They go
from a pendulum to a groupoid of one's own that is reduced and asked for its cheapest path. `ninja -C build/release` builds them, and a
test compares what they print with this page, which `./lagroid pages examples` writes. After them the [tutorial](tutorial.md) goes
through a larger one.
"""


def parts(source):
    """Of a program: its title, the lines of the comment below it but the last, which says how to run it, and its code."""
    lines = source.read_text().splitlines()
    count = next((k for k, line in enumerate(lines) if not line.startswith("//")), len(lines))
    comment = [line.removeprefix("//").removeprefix(" ") for line in lines[:count]]
    title = re.fullmatch(r"\d\d  (.+)\.", comment[0]) if count > 4 else None
    name = source.stem
    run = f"Run: ninja -C build/release {name} && build/release/bin/{name}"
    if title is None or comment[-1] != run or comment[-2] != "":
        raise ValueError(f"{source}: it opens with its number and its title, and the last line above its code is\n// {run}")
    return title[1], comment[2:-2], lines[count:]


def printed(source, programs):
    done = subprocess.run([programs / source.stem], capture_output=True, text=True, timeout=120)
    if done.returncode != 0:
        raise RuntimeError(f"{source.stem} returned {done.returncode}: {done.stdout}{done.stderr}")
    return done.stdout


def page(programs):
    """The text of docs/examples.md."""
    lines = [opening]
    for source in sources:
        title, said, code = parts(source)
        lines += [f"## {source.stem[:2]} {title}", "",
                  *said, "", f"[examples/cpp/{source.name}](../examples/cpp/{source.name}):", "",
                  "```cpp", *code, "```", "",
                  f"    build/release/bin/{source.stem}", "",
                  "```text", printed(source, programs).rstrip("\n"), "```", ""]
    return "\n".join(lines).rstrip("\n") + "\n"


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: examples.py PROGRAMS")
    written = page(pathlib.Path(sys.argv[1]).resolve())
    partial = root / "docs/examples.md.partial-page"
    partial.write_text(written)
    os.replace(partial, root / "docs/examples.md")


if __name__ == "__main__":
    main()
