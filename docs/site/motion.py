"""Draws docs/motion.svg, the moving picture of the front page: motion.py PROGRAM runs examples/figure_eight."""
import csv
import pathlib
import subprocess
import sys
import tempfile

root = pathlib.Path(__file__).resolve().parents[2]
picture = root / "docs/motion.svg"

scale, width, height = 260, 640, 240  # pixels: of a unit of length, of the picture
colours = ("#2980b9", "#c0392b", "#27ae60")
frames = 160


def nodes(program):
    """The places (x, y) of the three bodies at each node, and how long all of it lasts."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, folder], check=True, capture_output=True)
        with open(pathlib.Path(folder) / "trajectory.csv", newline="") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    places = [[(float(row[f"q{2 * b + 1}"]), float(row[f"q{2 * b + 2}"])) for b in range(3)] for row in rows]
    return places, float(rows[-1]["t"]) - float(rows[0]["t"])


def draw(places, seconds):
    """The curve on which they move, and a point for each, in its own time."""
    def pixels(x, y):
        return width / 2 + scale * x, height / 2 - scale * y

    kept = [places[round(k * (len(places) - 1) / frames)] for k in range(frames + 1)]
    curve = " ".join("{:.1f},{:.1f}".format(*pixels(*node[0])) for node in kept)
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}">',
             "<title>Three equal masses on a figure eight</title>",
             f'<polyline points="{curve}" fill="none" stroke="#b0b8be" stroke-width="1.5"/>']
    for body, colour in enumerate(colours):
        x, y = pixels(*kept[0][body])
        lines.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="9" fill="{colour}">')
        for axis, name in enumerate(("cx", "cy")):
            values = ";".join(f"{pixels(*node[body])[axis]:.1f}" for node in kept)
            lines.append(f'<animate attributeName="{name}" dur="{seconds:.2f}s" repeatCount="indefinite" values="{values}"/>')
        lines.append("</circle>")
    return "\n".join([*lines, "</svg>"]) + "\n"


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: motion.py PROGRAM")
    picture.write_text(draw(*nodes(pathlib.Path(sys.argv[1]).resolve())))
