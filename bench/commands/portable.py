"""What a portable program costs against one for this machine: both run scenes in turn, medians are compared.

    portable.py NATIVE PORTABLE    two programs lagroid; the page, in Markdown, on standard output
"""
import json
import pathlib
import statistics
import subprocess
import sys

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples"
ROUNDS = 7
SCENES = [
    ("rigid_body.toml", ["time.steps=400000"]),
    ("kepler.toml", ["time.steps=400000"]),
    ("heavy_top.toml", ["time.steps=200000"]),
    ("spherical_pendulum.toml", ["time.steps=200000"]),
    ("pendulum_chain.toml", ["time.steps=40000"]),
    ("chain_drop.toml", ["time.steps=200000"]),
    ("plate_ball.toml", ["time.steps=200"]),
]


def seconds(program, scene, settings):
    """The seconds of one run, as its summary says."""
    words = [program, "run", str(EXAMPLES / scene), "--json"]
    for setting in settings + ([] if scene == "plate_ball.toml" else ["output.every=1000"]):
        words += ["--set", setting]
    ended = subprocess.run(words, capture_output=True, text=True, check=False)
    if ended.returncode != 0:
        sys.exit(f"portable: {scene}: {ended.stderr.strip()}")
    return json.loads(ended.stdout)["seconds"]


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__.strip())
    native, portable = sys.argv[1:]
    rows = []
    for scene, settings in SCENES:
        times = [(seconds(native, scene, settings), seconds(portable, scene, settings)) for _ in range(ROUNDS)]
        ours, theirs = (statistics.median(column) for column in zip(*times))
        rows.append((scene, settings[0].split("=")[1], ours, theirs, statistics.median(t / o for o, t in times)))
    processor = next((line.split(": ")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), "?")
    print("# What a portable library costs\n")
    print(f"Written by `bench/commands/portable.py` on {processor}: medians of {ROUNDS} runs, by turns, in seconds.\n")
    print("| scene | steps | this machine's instructions | portable | portable over native |\n|---|---|---|---|---|")
    for scene, steps, ours, theirs, ratio in rows:
        print(f"| `examples/{scene}` | {steps} | {ours:.3f} | {theirs:.3f} | {ratio:.2f} |")


main()
