#!/usr/bin/python3
"""The page that `lagroid view` writes, opened in a browser: no errors, bodies that move, curves with data.

view_page.py LAGROID EXAMPLES
"""

import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

from selenium import webdriver

LAGROID, EXAMPLES = sys.argv[1], pathlib.Path(sys.argv[2])

# One scene for every shape and every way in which time goes on; an abandoned run; a long one, of which rows are left out.
SCENES = {
    "plate_ball_initial_value": [],
    "rolling_ball": [],
    "rolling_disk": [],
    "chaplygin_sleigh": [],
    "heavy_top": [],
    "rigid_body_moser_veselov": [],
    "spherical_pendulum": [],
    "pendulum_adaptive": [],
    "damped_pendulum": [],
    "driven_body": [],
    "kepler_controlled": [],
    "unicycle": [],
    "attitude_control": [],
    "driven_pendulum": ["time.steps=9001"],
    "chain_drop": [],
    "six_bar": [],
    "tops": [],
    "pendulum_chain": [],
}


def lagroid(*arguments):
    return subprocess.run([LAGROID, *arguments], capture_output=True, text=True, check=False)


def page_of(folder, scene, overrides=()):
    settings = [word for override in overrides for word in ("--set", override)]
    lagroid("run", str(EXAMPLES / f"{scene}.toml"), *settings, "--out", str(folder))
    made = lagroid("view", str(folder))
    assert made.returncode == 0, made.stderr
    return folder / "view.html"


def colours(png):
    """The different colours of a screenshot of the stage, by the browser itself."""
    return DRIVER.execute_async_script(
        """const done = arguments[1];
        const image = new Image();
        image.onload = () => {
          const canvas = document.createElement("canvas");
          [canvas.width, canvas.height] = [image.width, image.height];
          const paint = canvas.getContext("2d");
          paint.drawImage(image, 0, 0);
          const pixels = new Uint32Array(paint.getImageData(0, 0, image.width, image.height).data.buffer);
          done(new Set(pixels).size);
        };
        image.src = "data:image/png;base64," + arguments[0];""",
        png,
    )


def eventually(holds, seconds=30):
    """Whether it holds within that time: a busy machine draws few frames a second."""
    end = time.monotonic() + seconds
    while not holds():
        if time.monotonic() > end:
            return False
        time.sleep(0.05)
    return True


class Page(unittest.TestCase):
    def open(self, page):
        DRIVER.get(page.as_uri())
        errors = [entry for entry in DRIVER.get_log("browser") if entry["level"] == "SEVERE"]
        self.assertEqual(errors, [])

    def test_every_picture(self):
        for scene, overrides in SCENES.items():
            with self.subTest(scene), tempfile.TemporaryDirectory() as folder:
                page = page_of(pathlib.Path(folder) / "run", scene, overrides)
                self.open(page)
                self.assertNotIn("http", page.read_text().split('id="run">')[1].split("</script>")[0])
                points = DRIVER.execute_script("return lagroid.plots.points()")
                self.assertGreater(len(points), 1)
                self.assertGreater(min(points), 10)
                axes = DRIVER.execute_script(
                    """return lagroid.plots.plots.flatMap(({ chart }) =>
                       ["x", "y"].map((axis) => chart.scales[axis].ticks.map((tick) => tick.label)));"""
                )
                for labels in axes:
                    self.assertEqual(len(set(labels)), len(labels), f"labels repeat: {labels}")
                stage = DRIVER.find_element("id", "bodies")
                self.assertGreater(colours(stage.screenshot_as_base64), 20, "the stage is blank")
                before = DRIVER.execute_script("return lagroid.player.t")
                self.assertTrue(
                    eventually(lambda: DRIVER.execute_script("return lagroid.player.t") != before), "nothing moves"
                )
                errors = [entry for entry in DRIVER.get_log("browser") if entry["level"] == "SEVERE"]
                self.assertEqual(errors, [])

    def test_what_control_finds(self):
        """Motion where there is a picture, controls in steps, and bands behind the curves where inequalities act."""
        scenes = {"arm_of_bodies": 20, "keep_out": 30, "rolled_ball": 30, "through_a_gate": 0, "fastest_stop": 30}
        for scene, stages in scenes.items():
            with self.subTest(scene), tempfile.TemporaryDirectory() as folder:
                out = pathlib.Path(folder) / "found"
                fewer = ["--set", f"horizon.stages={stages}"] if stages else []
                arguments = ["--set", "solver.starts=2", *fewer, "--out", str(out)]
                found = lagroid("control", str(EXAMPLES / "control" / f"{scene}.toml"), *arguments)
                self.assertEqual(found.returncode, 0, found.stderr)
                self.assertEqual(lagroid("view", str(out)).returncode, 0)
                self.open(out / "view.html")
                has_picture = DRIVER.execute_script("return lagroid.stage !== null")
                self.assertEqual(has_picture, scene != "fastest_stop")
                nothing = DRIVER.find_element("id", "nothing")
                self.assertEqual("no picture in space" in nothing.text, not has_picture)
                if has_picture:
                    stage = DRIVER.find_element("id", "bodies")
                    self.assertGreater(colours(stage.screenshot_as_base64), 20, "the stage is blank")
                self.assertGreater(min(DRIVER.execute_script("return lagroid.plots.points()")), 10)
                # A pixel of a band has its colour, at the top where no curve is.
                shaded = """const run = JSON.parse(document.getElementById("run").textContent);
                    return run.panels.flatMap(({ bands }, i) => bands.map(([from, to]) => {
                      const { chart } = lagroid.plots.plots[i];
                      chart.draw();
                      const scale = chart.currentDevicePixelRatio;
                      const x = chart.scales.x.getPixelForValue((from + to) / 2);
                      const pixel = chart.ctx.getImageData(x * scale, (chart.chartArea.top + 2) * scale, 1, 1).data;
                      return [...pixel].slice(0, 3);
                    }));"""
                self.assertTrue(eventually(lambda: [0xF6, 0xEA, 0xD0] in DRIVER.execute_script(shaded)), "no band")
                # Controls are constant along an arrow: the mark is at the number of the row that the arrow leads to.
                steps = DRIVER.execute_script(
                    """const run = JSON.parse(document.getElementById("run").textContent);
                    const i = run.panels.findIndex(({ steps }) => steps);
                    const values = run.columns[run.panels[i].curves[0]];
                    return [lagroid.plots.plots[i].curves[0](4.5), values[5], values[0]];"""
                )
                self.assertEqual(steps[0], steps[1])
                self.assertIsNone(steps[2])
                errors = [entry for entry in DRIVER.get_log("browser") if entry["level"] == "SEVERE"]
                self.assertEqual(errors, [])

    def test_what_happened(self):
        """Events are points on the curves, a section of their own, and a list that leads to their times."""
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder) / "scene.toml"
            event = '[[event]]\nname = "it\'s far"\nwhen = "x*px + y*py"\ndirection = "falling"\nplot = ["x", "py"]\n'
            scene.write_text((EXAMPLES / "kepler_order_8.toml").read_text() + event)
            out = pathlib.Path(folder) / "run"
            ran = lagroid("run", str(scene), "--set", "time.steps=400", "--out", str(out))
            self.assertEqual(ran.returncode, 0, ran.stderr)
            self.assertEqual(lagroid("view", str(out)).returncode, 0)
            self.open(out / "view.html")
            drawn = DRIVER.execute_script(
                """const counts = ({ chart }) => chart.data.datasets.at(-1).data.length;
                   return [lagroid.plots.plots.map(counts), lagroid.plots.sections.map(counts)];"""
            )
            rows = len((out / "events.csv").read_text().splitlines()) - 1
            self.assertGreater(rows, 5)
            self.assertIn(rows, drawn[0])
            self.assertEqual(drawn[1], [rows])
            options = DRIVER.execute_script("return [...document.getElementById('happened').options].map((o) => o.text)")
            self.assertEqual(len(options), rows + 1)
            self.assertTrue(options[1].startswith("it's far, falling, t = "), options[1])
            at = DRIVER.execute_script(
                """const list = document.getElementById("happened");
                   list.selectedIndex = 1;
                   list.dispatchEvent(new Event("change"));
                   return [lagroid.player.t, Number(list.value), lagroid.player.playing];"""
            )
            self.assertEqual(at[0], at[1])
            self.assertFalse(at[2])

    def test_pause_and_scrub(self):
        with tempfile.TemporaryDirectory() as folder:
            self.open(page_of(pathlib.Path(folder) / "run", "rigid_body"))
            DRIVER.find_element("id", "play").click()
            time.sleep(0.1)
            at = DRIVER.execute_script("return lagroid.player.t")
            time.sleep(0.3)
            self.assertEqual(DRIVER.execute_script("return lagroid.player.t"), at, "it moves while paused")
            where = """const { group } = lagroid.stage.bodies[0];
                const scrub = document.getElementById("scrub");
                scrub.value = arguments[0] * scrub.max;
                scrub.dispatchEvent(new Event("input"));
                const row = lagroid.player.row();
                lagroid.stage.draw(row);
                return [row, ...group.quaternion.toArray()];"""
            first, middle = (DRIVER.execute_script(where, share) for share in (0, 0.5))
            self.assertEqual(first[0], 0)
            self.assertGreater(middle[0], 1)
            self.assertGreater(max(abs(a - b) for a, b in zip(first[1:], middle[1:])), 0.05)

    def test_bodies_are_where_the_run_says(self):
        with tempfile.TemporaryDirectory() as folder:
            self.open(page_of(pathlib.Path(folder) / "run", "spherical_pendulum"))
            for share in (0, 0.3, 1):
                recorded, shown = DRIVER.execute_script(
                    """const run = JSON.parse(document.getElementById("run").textContent);
                    const row = Math.round(arguments[0] * (run.time.length - 1));
                    lagroid.stage.draw(row);
                    const shown = lagroid.stage.bodies[1].centre().toArray();
                    return [["x", "y", "z"].map((column) => run.columns[column][row]), shown];""",
                    share,
                )
                for a, b in zip(recorded, shown):
                    self.assertAlmostEqual(a, b, places=6)

    def test_rows_left_out_are_said(self):
        with tempfile.TemporaryDirectory() as folder:
            self.open(page_of(pathlib.Path(folder) / "run", "driven_pendulum", ["time.steps=9001"]))
            self.assertIn("of 9002 recorded rows", DRIVER.find_element("id", "notes").text)

    def test_a_failed_run_is_shown_as_such(self):
        with tempfile.TemporaryDirectory() as folder:
            page = page_of(
                pathlib.Path(folder) / "run",
                "pendulum_adaptive",
                ["parameters.quadrature=trapezoid", "time.without_root=stop"],
            )
            self.open(page)
            self.assertIn("no_step", DRIVER.find_element("css selector", "#status.failed").text)


if __name__ == "__main__":
    options = webdriver.ChromeOptions()
    for flag in ("headless=new", "no-sandbox", "disable-dev-shm-usage", "use-angle=swiftshader",
                 "enable-unsafe-swiftshader", "window-size=1200,900"):
        options.add_argument(f"--{flag}")
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    DRIVER = webdriver.Chrome(options=options)
    try:
        unittest.main(argv=sys.argv[:1], verbosity=2)
    finally:
        DRIVER.quit()
