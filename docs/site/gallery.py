"""Writes docs/gallery.md and its pictures: gallery.py PROGRAM runs the scenes below and takes what each says of itself."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

root = pathlib.Path(__file__).resolve().parents[2]

# Scenes by subject, with the settings that keep a picture small.
gallery = {
    "The cheapest way": {
        "plate_ball": [], "unicycle": [], "attitude_control": [], "kepler_boundary": []},
    "Orbits": {
        "kepler": ["time.steps=2000", "output.every=4"], "figure_eight": ["output.every=40"],
        "pythagorean": ["output.every=20000"], "kepler_controlled": ["time.steps=800"]},
    "Bodies that turn": {
        "rigid_body": ["time.steps=1000"], "heavy_top": ["time.steps=1000"], "tops": ["output.every=20"],
        "tumbling_book": ["output.every=10"]},
    "Pendula": {
        "spherical_pendulum": ["output.every=2"], "spring_pendulum": ["output.every=30"], "foucault": ["output.every=12"],
        "upside_down": ["output.every=45"], "pendulum_chain": ["output.every=10"]},
    "Rolling and sliding": {
        "rolling_ball": ["output.every=3"], "rolling_disk": ["output.every=2"], "chaplygin_sleigh": ["output.every=2"],
        "two_ways_to_roll": ["output.every=4"], "steering": ["output.every=4"]},
    "Many bodies": {
        "chain_drop": ["output.every=30"], "six_bar": ["output.every=30"], "rolling_balls": ["output.every=18"]},
}


def caption(scene):
    """The comment that opens a scene, as one paragraph."""
    lines = []
    for line in scene.read_text().splitlines():
        if not line.startswith("#"):
            break
        lines.append(line.removeprefix("#").strip())
    said = " ".join(lines)
    if not said:
        sys.exit(f"gallery: {scene}: the scene does not open with what it is; write a comment there")
    return re.sub(r"(?=[*_\[\]<])", r"\\", said)


def draw(program, name, settings, pictures):
    """Runs the scene; its command and the place of its picture."""
    with tempfile.TemporaryDirectory() as folder:
        command = ["run", f"examples/{name}.toml", *(word for setting in settings for word in ("--set", setting))]
        done = subprocess.run([program, *command, "--out", folder], cwd=root, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"gallery: lagroid {' '.join(command)}: {done.stderr.strip()}")
        shutil.copy(pathlib.Path(folder) / "plot.svg", pictures / f"{name}.svg")
    return f"./lagroid {' '.join(command)} --out out/{name}"


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: gallery.py PROGRAM")
    page = ["# Gallery", "",
            "Every picture is the `plot.svg` of a run: the command below it draws it again, `./lagroid view` of the same folder moves "
            "it. `./lagroid pages gallery` writes this page."]
    with tempfile.TemporaryDirectory(dir=root / "docs") as drawn:
        pictures = pathlib.Path(drawn)
        for subject, scenes in gallery.items():
            page += ["", f"## {subject}"]
            for name, settings in scenes.items():
                command = draw(pathlib.Path(sys.argv[1]).resolve(), name, settings, pictures)
                page += ["", f"### {name.replace('_', ' ').capitalize()}", "", caption(root / f"examples/{name}.toml"),
                         f"([scene](../examples/{name}.toml))", "", f"    {command}", "", f"![{name}](gallery/{name}.svg)"]
        (pictures / "gallery.md").write_text("\n".join(page) + "\n")
        shutil.rmtree(root / "docs/gallery", ignore_errors=True)
        (root / "docs/gallery").mkdir()
        for picture in pictures.glob("*.svg"):
            shutil.move(picture, root / "docs/gallery" / picture.name)
        os.replace(pictures / "gallery.md", root / "docs/gallery.md")


main()
