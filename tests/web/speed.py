#!/usr/bin/python3
"""Steps a second in WebAssembly beside those of the program, and what a reader waits for:
speed.py LAGROID GLUE SITE EXAMPLES [PAGE]

Both run the same scene in turn, five times; the ratio is that of the medians. With PAGE, the table there is written anew.
"""
import gzip
import json
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile
import time

from browser import driver, eventually, fragment, frames, links

LAGROID, GLUE, SITE, EXAMPLES = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3]).resolve(), pathlib.Path(sys.argv[4])
BEGIN, END = "<!-- speed -->\n", "<!-- end of speed -->\n"
RUN = pathlib.Path(__file__).with_name("run_scene.mjs")
SCENES = {
    "pendulum": ["time.steps=400000", "output.every=1000"],
    "rigid_body": ["time.steps=400000", "output.every=1000"],
    "plate_ball_initial_value": ["time.step=0.0001", "time.steps=100000", "output.every=1000"],
    "chain of 20": ["time.steps=20000", "output.every=100"],
}


def processor_time(words):
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run(words, capture_output=True, check=True)
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def rate(command, settings):
    """Steps a second of processor time: of a long run less a short one, for both begin with what is no step."""
    long = next(int(setting.split("=")[1]) for setting in settings if setting.startswith("time.steps="))
    short = long // 10
    took = processor_time(command(settings)) - processor_time(command([*settings, f"time.steps={short}"]))
    return (long - short) / max(took, 1e-3)


def native(scene, folder):
    return lambda settings: [LAGROID, "run", scene, *(word for setting in settings for word in ("--set", setting)), "--out",
                             tempfile.mkdtemp(dir=folder) + "/run"]


def compiled(scene):
    return lambda settings: ["node", RUN, GLUE, scene, *settings]


def speeds():
    yield "| steps a second | program | WebAssembly | ratio |\n|---|---|---|---|\n"
    with tempfile.TemporaryDirectory() as folder:
        for name, settings in SCENES.items():
            scene = EXAMPLES / f"{name}.toml"
            if not scene.exists():
                scene = pathlib.Path(folder) / "chain.toml"
                scene.write_text(links(20))
            both = [(rate(native(scene, folder), settings), rate(compiled(scene), settings)) for _ in range(5)]
            ours, theirs = (statistics.median(rates) for rates in zip(*both, strict=True))
            yield f"| {name.replace('_', ' ')} | {ours:.2g} | {theirs:.2g} | {theirs / ours:.2f} |\n"


def first_load():
    """In MB, with gzip: what a server sends before a page is there."""
    files = [SITE / name for name in ("index.html", "page.css", "page.js", "worker.js", "lagroid.wasm")]
    return sum(len(gzip.compress(file.read_bytes())) for file in files) / 1e6


def opened():
    """Seconds until the page in one file answers, and ms of its own work in a frame of a chain of 20 that runs."""
    browser = driver()
    try:
        browser.get("about:blank")
        begun = time.monotonic()
        browser.get((SITE / "lagroid.html").as_uri() + fragment(scene=links(20)))
        run = browser.find_element("id", "run")
        eventually(run.is_enabled)
        ready = time.monotonic() - begun
        run.click()
        eventually(lambda: len(frames(browser)) > 50)
        return ready, statistics.median(frames(browser))
    finally:
        browser.quit()


ready, frame = opened()
table = f"""{"".join(speeds())}
A first load is {first_load():.1f} MB, compressed by gzip; the page answers {ready:.1f} s after it is opened; a frame of a
chain of 20 that runs takes {frame:.1f} ms of its own work.
"""
if len(sys.argv) > 5:
    page = pathlib.Path(sys.argv[5])
    head, rest = page.read_text().split(BEGIN)
    page.write_text(head + BEGIN + table + END + rest.split(END)[1])
else:
    print(table, end="")
