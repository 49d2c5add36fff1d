#!/usr/bin/env python3
"""What building takes, from nothing: `./lagroid bench build [--page]`.

Clones the commit that is checked out, without ccache, and times what a newcomer waits for, one after another in the same
build: the demo, everything of the program, the tests, a system of one's own from C++. apt's time is not in it.
"""
import argparse
import json
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import tempfile
import time

root = pathlib.Path(__file__).resolve().parents[2]
# Seconds of wall clock and of processor.
goals = {"demo": (300, 420), "tests": (1200, None), "a system of one's own": (20, None), "the same again": (1, None),
         "its study, boundary value and laws": (60, None)}
ends = """system = "spring_bob"
[time]
step = 0.05
steps = 40
[boundary]
start = {position = [1.0, 0.0]}
end = {position = [0.0, 1.0]}
"""
dearest = 25  # seconds of processor that a file may take


def timed(command, cwd):
    """Seconds of wall clock and of processor."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    subprocess.run(command, cwd=cwd, check=True, stdin=subprocess.DEVNULL, stdout=sys.stderr)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.monotonic() - start, (after.ru_utime + after.ru_stime) - (before.ru_utime + before.ru_stime)


def measure(folder, tests):
    """Rows of (what, command, wall, processor), and what each file took."""
    clone = folder / "lagroid"
    subprocess.run(["git", "clone", "-q", str(root), str(clone)], check=True)
    log = folder / "files.jsonl"
    launcher = f"{sys.executable};{clone}/bench/commands/processor_time.py;{log}"
    rows = []

    def add(what, command, beside=()):
        rows.append((what, " ".join(command), *timed([*command, *beside], clone)))

    # As on a machine without ccache: with precompiled headers, and a launcher that only looks at the clock.
    add("configure", ["cmake", "--preset", "release", "-DCCACHE=OFF", "-DLAGROID_PRECOMPILE=ON"],
        beside=[f"-DCMAKE_CXX_COMPILER_LAUNCHER={launcher}"])
    add("demo", ["./lagroid", "demo"])
    add("laws of its system", ["./lagroid", "check", "examples/plate_ball.toml", "--samples", "1"])
    add("another system", ["./lagroid", "run", "examples/kepler.toml"])
    add("whole program", ["ninja", "-C", "build/release", "lagroid_own"])
    if tests:
        add("tests", ["ninja", "-C", "build/release"])
    os.environ["XDG_CACHE_HOME"] = str(folder)
    own = folder / "spring_bob"
    source, scene = str(own / "spring_bob.cpp"), str(own / "spring_bob.toml")
    subprocess.run(["./lagroid", "new", "system", "spring_bob", "--out", str(own)], cwd=clone, check=True, stdout=sys.stderr)
    (own / "ends.toml").write_text(ends)
    add("a system of one's own", ["./lagroid", "run", source])
    add("the same again", ["./lagroid", "run", source])
    first = len(rows)
    for words in (["study", scene, "--budget", "5"], ["run", str(own / "ends.toml")], ["check", scene]):
        add("", ["./lagroid", "run", source, *words])
    taken = rows[first:]
    rows[first:] = [("its study, boundary value and laws", "./lagroid run SOURCE study, run and check",
                     sum(wall for _, _, wall, _ in taken), sum(processor for *_, processor in taken))]
    rows = [(what, command.replace(str(own), "spring_bob"), *times) for what, command, *times in rows]
    files = {}
    for line in log.read_text().splitlines():
        entry = json.loads(line)
        if entry["file"].endswith(".o"):
            files[entry["file"].replace("CMakeFiles/", "").replace(".dir/", "/").removesuffix(".o")] = entry
    return rows, files


def seconds(time):
    return f"{time:.0f} s" if time >= 10 else f"{time:.1f} s"


def page(rows, files):
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=root, capture_output=True, text=True).stdout.strip()
    cores = subprocess.run(["nproc"], capture_output=True, text=True).stdout.strip()
    model = next((line.split(":")[1].strip() for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines()
                  if line.startswith("model name")), "unknown processor")
    out = ["# What building takes", "",
           f"Written by `{' '.join(['./lagroid bench build', *sys.argv[1:]])}` at commit {commit}, on {cores} cores ({model}), without ccache, apt's",
           "time apart. Each row goes on in the build of those before it.", "",
           "| what | command | wall | processor | goal | verdict |", "|---|---|---|---|---|---|"]
    for what, command, wall, processor in rows:
        goal, verdict = "", ""
        if what in goals:
            most_wall, most_processor = goals[what]
            goal = f"{most_wall} s" + (f", {most_processor} s of processor" if most_processor else "")
            verdict = "reached" if wall <= most_wall and (not most_processor or processor <= most_processor) else "missed"
        out.append(f"| {what} | `{command}` | {seconds(wall)} | {seconds(processor)} | {goal} | {verdict} |")
    above = [name for name, entry in files.items() if entry["seconds"] > dearest]
    out += ["", f"Of {len(files)} files {len(above)} take more than {dearest} s of processor. The dearest:", "",
            "| file | processor | memory |", "|---|---|---|"]
    for name, entry in sorted(files.items(), key=lambda item: -item[1]["seconds"])[:20]:
        out.append(f"| {name} | {entry['seconds']:.1f} s | {entry['megabytes']} MB |")
    return "\n".join(out) + "\n"


def main():
    parser = argparse.ArgumentParser(prog="lagroid bench build", description=__doc__.split("\n\n")[0])
    parser.add_argument("--page", action="store_true", help="write docs/build_times.md")
    parser.add_argument("--without-tests", action="store_true", help="leave out what the tests take")
    options = parser.parse_args()
    folder = pathlib.Path(tempfile.mkdtemp(prefix="lagroid-build-"))
    try:
        text = page(*measure(folder, not options.without_tests))
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    if options.page:
        (root / "docs/build_times.md").write_text(text)
    print(text, end="")


main()
