"""Draws docs/architecture.svg, the layers and what includes what, from the sources: architecture.py"""
import pathlib
import re
import subprocess

root = pathlib.Path(__file__).resolve().parents[2]
picture = root / "docs/architecture.svg"

# Each may include those before it; python/ is beside app/, which it knows nothing of.
layers = {
    "core": "the language",
    "groupoids": "where motions live",
    "solvers": "steps, integrators, boundary values",
    "systems": "what moves",
    "run": "motions followed, recorded, judged",
    "app": "scenes and commands",
    "python": "the package lagroid",
}


def includes(top=root):
    """The pairs of layers (one that includes, one that is included)."""
    edges = set()
    for layer in layers:
        for file in (top / layer).rglob("*"):
            if file.suffix in (".hpp", ".cpp", ".in") and file.is_file():
                edges |= {(layer, other) for other in re.findall(r"#include <lagroid/(\w+)/", file.read_text())
                          if other in layers and other != layer}
    return edges


def upward(edges):
    """Those that the rule of layers forbids."""
    order = [*layers]
    return sorted(edge for edge in edges
                  if order.index(edge[0]) < order.index(edge[1]) or edge == ("python", "app"))


def implied(edges):
    """Those that a longer way along the others makes no news."""
    def leads(start, end):
        return any(middle == end or leads(middle, end) for first, middle in edges if first == start)

    return {(start, end) for start, end in edges
            if any(leads(middle, end) for first, middle in edges if first == start and middle != end)}


def rooms(layer, top=root):
    """The folders of a layer, without those inside of them."""
    return sorted(path.name for path in (top / layer).iterdir()
                  if path.is_dir() and not path.name.startswith(("_", ".")))


def label(layer):
    lines, width = [""], 44
    for room in rooms(layer):
        if len(lines[-1]) + len(room) > width:
            lines.append("")
        lines[-1] += ("  " if lines[-1] else "") + room
    small = "".join(f'<br/><font point-size="11" color="#555555">{line.replace("  ", "&#160;&#160; ")}</font>'
                    for line in lines if line)
    return f'<<b>{layer}/</b>&#160; {layers[layer]}{small}>'


def dot():
    """The graph, in graphviz's language."""
    edges = includes()
    lines = ["digraph architecture {", '  rankdir=BT; nodesep=0.6; ranksep=0.35;',
             '  node [shape=box, style="filled,rounded", fillcolor="#eef4f8", color="#2980b9", fontname="sans-serif",'
             ' fontsize=14, margin="0.2,0.1"];',
             '  edge [color="#2980b9", penwidth=1.5];']
    lines += [f"  {layer} [label={label(layer)}];" for layer in layers]
    faint = ' [color="#c9ced3", penwidth=0.8]'
    lines += [f"  {start} -> {end}{faint if (start, end) in implied(edges) else ''};" for start, end in sorted(edges)]
    return "\n".join([*lines, "}"]) + "\n"


def shown(svg):
    """The edges of a picture that graphviz drew."""
    return set(re.findall(r"<title>(\w+)&#45;&gt;(\w+)</title>", svg))


if __name__ == "__main__":
    drawn = subprocess.run(["dot", "-Tsvg"], input=dot(), capture_output=True, text=True, check=True).stdout
    # Neither the version of graphviz nor a comment for each node is of interest.
    picture.write_text(re.sub(r"<!-- .*? -->\n", "", drawn, flags=re.S))
