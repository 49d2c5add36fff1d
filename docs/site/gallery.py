"""Writes docs/gallery.md and its pictures: gallery.py PROGRAM runs the scenes below, and the examples' programs beside it."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

root = pathlib.Path(__file__).resolve().parents[2]

# Scenes by subject, with the settings that keep a picture small; `a_program` of examples/ instead of a scene.
a_program = None


class Fitted(list):
    """Words of `lagroid fit` after the scene, in place of settings."""


gallery = {
    "The cheapest way": {
        "plate_ball": [], "unicycle": [], "attitude_control": [], "kepler_boundary": []},
    "Bounds, obstacles and free time": {
        "control/swing_up": [], "control/keep_out": [], "control/fastest_stop": [], "control/shortest_way": [],
        "control/reeds_shepp": [], "control/parallel_parking": [], "control/falling_cat": [], "control/two_link_arm": [],
        "control/low_thrust": [], "control/low_thrust_coast": [], "control/through_a_gate": [], "control/rolled_ball": [],
        "control/arm_of_bodies": [], "control/cat_of_bodies": []},
    "Orbits": {
        "kepler": ["time.steps=2000", "output.every=4"], "figure_eight": ["output.every=40"],
        "pythagorean": ["output.every=20000"], "kepler_controlled": ["time.steps=800"]},
    "Bodies that turn": {
        "rigid_body": ["time.steps=1000"], "heavy_top": ["time.steps=1000"], "tops": ["output.every=20"],
        "tumbling_book": ["output.every=10"], "geometric_phase": a_program},
    "Pendula": {
        "spherical_pendulum": ["output.every=2"], "spring_pendulum": ["output.every=30"],
        "foucault": ["output.every=12"],
        "upside_down": ["output.every=45"], "pendulum_chain": ["output.every=10"]},
    "Rolling and sliding": {
        "rolling_ball": ["output.every=3"], "rolling_disk": ["output.every=2"], "chaplygin_sleigh": ["output.every=2"],
        "two_ways_to_roll": ["output.every=4"], "steering": ["output.every=4"]},
    "Many bodies": {
        "chain_drop": ["output.every=30"], "six_bar": ["output.every=30"], "rolling_balls": ["output.every=18"]},
    "Parameters from data": {
        "damped_pendulum": Fitted(["examples/measured_pendulum.csv", "--wrt", "initial,parameters.length,parameters.damping",
                                   "--sigma", "q=0.01"])},
}


def source(name, settings):
    return f"examples/{name}.{'cpp' if settings is a_program else 'toml'}"


def picture(name, settings=()):
    return ("fit_" if isinstance(settings, Fitted) else "") + name.replace("/", "_") + ".svg"


def caption(file):
    """The comment that opens a scene or a program, as one paragraph; of a program up to its first empty line."""
    mark = "//" if file.suffix == ".cpp" else "#"
    lines = []
    for line in file.read_text().splitlines():
        if not line.startswith(mark) or line == "//":
            break
        lines.append(line.removeprefix(mark).strip())
    said = " ".join(lines)
    if not said:
        sys.exit(f"gallery: {file}: it does not open with what it is; write a comment there")
    return re.sub(r"(?=[*_\[\]<])", r"\\", said)


def command(name, settings, folder):
    """The words that draw a picture into the folder."""
    if settings is a_program:
        return [f"build/release/bin/{name}", folder]
    if isinstance(settings, Fitted):
        return ["./lagroid", "fit", source(name, settings), *settings, "--out", folder]
    changed = (word for setting in settings for word in ("--set", setting))
    verb = "control" if name.startswith("control/") else "run"
    return ["./lagroid", verb, source(name, settings), *changed, "--out", folder]


def page():
    """The text of docs/gallery.md."""
    lines = ["# Gallery", "",
             "Every picture is the `plot.svg` of a run: the command above it draws it again, `./lagroid view` of",
             "the same folder moves it. `./lagroid pages gallery` writes this page. On the documentation site scenes have a link that runs",
             "them [in the browser](web.md)."]
    for subject, scenes in gallery.items():
        lines += ["", f"## {subject}"]
        for name, settings in scenes.items():
            file = source(name, settings)
            title = name.split("/")[-1].replace("_", " ").capitalize()
            lines += ["", f"### {title}", "", caption(root / file),
                      f"([{'program' if settings is a_program else 'scene'}](../{file}))", "",
                      f"    {' '.join(command(name, settings, f'out/gallery/{name}'))}", "",
                      f"![{name}](gallery/{picture(name, settings)})"]
    return "\n".join(lines) + "\n"


def draw(program, name, settings, pictures):
    """Runs the scene or the program and keeps its picture."""
    with tempfile.TemporaryDirectory() as folder:
        _, *arguments = words = command(name, settings, folder)
        runs = program.parent / name if settings is a_program else program
        if isinstance(settings, Fitted):
            runs = program.parent / "parts" / name / "lagroid-gradient"
        done = subprocess.run([runs, *arguments], cwd=root, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"gallery: {' '.join(words)}: {done.stderr.strip()}")
        shutil.copy(pathlib.Path(folder) / "plot.svg", pictures / picture(name, settings))


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: gallery.py PROGRAM")
    program = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory(dir=root / "docs") as drawn:
        pictures = pathlib.Path(drawn)
        for scenes in gallery.values():
            for name, settings in scenes.items():
                draw(program, name, settings, pictures)
        shutil.rmtree(root / "docs/gallery", ignore_errors=True)
        (root / "docs/gallery").mkdir()
        for picture in pictures.glob("*.svg"):
            shutil.move(picture, root / "docs/gallery" / picture.name)
        (pictures / "gallery.md").write_text(page())
        os.replace(pictures / "gallery.md", root / "docs/gallery.md")


if __name__ == "__main__":
    main()
