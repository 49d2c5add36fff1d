#!/usr/bin/env python3
"""What another commit of lagroid costs and computes: `./lagroid bench against COMMIT`.

Both programs are compiled for processors that callgrind knows (x86-64-v3), and without fused multiply-adds, so that a
number is the same however the compiler orders the code around it. Then, of each example that both can run: the
instructions of one step of a run (callgrind; two lengths, so that starting does not count), judged alone and written
into a folder; and whether trajectory.csv has the same bytes. Prints the table in Markdown. Exits with 1 where a number
differs, or a step takes more than 1.02 of its instructions.
"""
import argparse
import csv
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

root = pathlib.Path(__file__).resolve().parents[2]
cost_allowed = 1.02
few, many = 400, 1400  # steps: the difference of two runs
counted = ["pendulum", "rigid_body", "kepler", "heavy_top", "spherical_pendulum", "plate_ball_initial_value", "pendulum_chain",
           "chain_drop"]


def built(name, commit, jobs):
    """The program of a commit (None: of the working tree), built in build/against/NAME."""
    build = root / "build" / "against" / name
    source = root
    if commit:
        source = build / "source"
        if not source.exists():
            subprocess.run(["git", "clone", "-q", str(root), str(source)], check=True)
        subprocess.run(["git", "checkout", "-q", "--detach", commit], cwd=source, check=True)
    subprocess.run(["cmake", "-G", "Ninja", "-S", str(source), "-B", str(build), "-DCMAKE_BUILD_TYPE=Release",
                    "-DLAGROID_ARCH=x86-64-v3", "-DCMAKE_CXX_FLAGS=-ffp-contract=off", "-DLAGROID_TESTS=OFF",
                    "-DLAGROID_PYTHON=OFF", "-DLAGROID_BENCH=OFF"], check=True, stdout=sys.stderr)
    subprocess.run(["ninja", "-C", str(build), "-j", str(jobs), "lagroid_cli"], check=True, stdout=sys.stderr)
    return build / "bin" / "lagroid"


def instructions(program, scene, folder):
    """Of one step of a run, and of one that is written into a folder."""

    def count(steps, files):
        command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", str(program), "run", str(scene), "--set",
                   f"time.steps={steps}", "--set", "output.every=1"]
        if files:
            shutil.rmtree(folder, ignore_errors=True)
            command += ["--out", str(folder)]
        ended = subprocess.run(command, capture_output=True, text=True, check=False)
        if ended.returncode:
            return None
        return int(re.search(r"Collected : (\d+)", ended.stderr).group(1))

    out = []
    for files in (False, True):
        short, long = count(few, files), count(many, files)
        out.append(None if short is None or long is None else (long - short) / (many - few))
    return out


def trajectory(program, scene, folder):
    """The file's bytes, or None where the program cannot run the scene, or runs no trajectory."""
    shutil.rmtree(folder, ignore_errors=True)
    subprocess.run([str(program), "run", str(scene), "--out", str(folder)], capture_output=True, check=False)
    file = folder / "trajectory.csv"
    return file.read_text() if file.exists() else None


def difference(before, after):
    """What tells two trajectories apart, in a few words."""
    tables = [list(csv.reader(line for line in text.splitlines() if not line.startswith("#"))) for text in (before, after)]
    if tables[0][0] != tables[1][0]:
        missing = sorted(set(tables[0][0]) ^ set(tables[1][0]))
        common = [name for name in tables[0][0] if name in tables[1][0]]
        words = f"columns differ: {' '.join(missing)}" if missing else "the same columns in another order"
    else:
        common, words = tables[0][0], ""
    if len(tables[0]) != len(tables[1]):
        return f"{words}; {len(tables[0]) - 1} rows and {len(tables[1]) - 1}"
    largest, first = 0.0, None
    for row, (a, b) in enumerate(zip(tables[0][1:], tables[1][1:])):
        for name in common:
            x, y = a[tables[0][0].index(name)], b[tables[1][0].index(name)]
            if x != y:
                first = first if first is not None else row
                largest = max(largest, abs(float(x or "nan") - float(y or "nan")))
    if first is None:
        return f"same numbers; {words}"
    return f"{words + '; ' if words else ''}from row {first} on, by {largest:.1e} at most"


def main():
    parser = argparse.ArgumentParser(prog="lagroid bench against", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("commit", nargs="?", help="the commit to compare with")
    parser.add_argument("--programs", nargs=2, metavar=("BEFORE", "AFTER"), help="two programs that were built like that")
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    if bool(options.commit) == bool(options.programs):
        parser.error("name a commit, or two --programs")
    before, after = options.programs or (built("before", options.commit, options.jobs), built("after", None, options.jobs))
    bad = False
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch) / "run"
        print("| a step of a run | before | after | ratio | written, before | after | ratio |\n|---|---|---|---|---|---|---|")
        for name in counted:
            scene = root / "examples" / f"{name}.toml"
            old, new = instructions(before, scene, folder), instructions(after, scene, folder)
            cells = [name]
            for a, b in zip(old, new):
                cells += [f"{a:.0f}" if a else "", f"{b:.0f}" if b else "", f"{b / a:.3f}" if a and b else ""]
                bad = bad or bool(a and b and b / a > cost_allowed)
            print(f"| {' | '.join(cells)} |", flush=True)
        print("\n| example | trajectory.csv |\n|---|---|")
        for scene in sorted((root / "examples").glob("*.toml")):
            old, new = trajectory(before, scene, folder), trajectory(after, scene, folder)
            if old is None or new is None:
                which = "neither" if old is None and new is None else "no trajectory before" if old is None else "no trajectory after"
                bad = bad or (new is None and old is not None)
                print(f"| {scene.stem} | {which} |", flush=True)
                continue
            same = old == new
            bad = bad or not same
            print(f"| {scene.stem} | {'same bytes' if same else difference(old, new)} |", flush=True)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
