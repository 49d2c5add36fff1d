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
from selenium.webdriver.common.keys import Keys

LAGROID, EXAMPLES = sys.argv[1], pathlib.Path(sys.argv[2])

# One scene for every shape and every way in which time goes on; an abandoned run; a long one, of which rows are left
# out.
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

# Of each panel what its legend says, as far as it is seen, and the names of its curves.
NAMED = """const run = JSON.parse(document.getElementById("run").textContent);
    const figures = [...document.querySelectorAll("figure")];
    const said = (figure) => [...figure.querySelectorAll(".legend li")].map((item) => item.innerText.trim());
    return run.panels.map(({ curves }, i) => [said(figures[i]), curves]);"""


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


def severe(driver):
    return [entry for entry in driver.get_log("browser") if entry["level"] == "SEVERE"]


def browser(*flags):
    options = webdriver.ChromeOptions()
    for flag in ("headless=new", "no-sandbox", "disable-dev-shm-usage", "window-size=1200,900", *flags):
        options.add_argument(f"--{flag}")
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = webdriver.Chrome(options=options)
    driver.set_script_timeout(120)
    return driver


def is_tint(pixel, colour):
    """Whether it is that colour, given as #rrggbb, mixed with white."""
    parts = [int(colour[at : at + 2], 16) for at in (1, 3, 5)]
    shares = [(255 - a) / (255 - b) for a, b in zip(pixel, parts)]
    return max(shares) - min(shares) < 0.05 and 0.05 < min(shares) < 0.5


def eventually(holds, seconds=60):
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
        self.assertEqual(severe(DRIVER), [])

    def control(self, folder, scene, *settings):
        """The page of what an optimal control scene of the examples comes to."""
        out = pathlib.Path(folder) / "found"
        words = [word for setting in ("solver.starts=2", *settings) for word in ("--set", setting)]
        found = lagroid("control", str(EXAMPLES / "control" / f"{scene}.toml"), *words, "--out", str(out))
        self.assertEqual(found.returncode, 0, found.stderr)
        self.assertEqual(lagroid("view", str(out)).returncode, 0)
        return out / "view.html"

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
                for said, curves in DRIVER.execute_script(NAMED):
                    self.assertEqual(said[: len(curves)], curves)
                stage = DRIVER.find_element("id", "bodies")
                self.assertTrue(eventually(lambda: colours(stage.screenshot_as_base64) > 20), "the stage is blank")
                before = DRIVER.execute_script("return lagroid.player.t")
                self.assertTrue(
                    eventually(lambda: DRIVER.execute_script("return lagroid.player.t") != before), "nothing moves"
                )
                self.assertEqual(severe(DRIVER), [])

    def test_what_control_finds(self):
        """Motion where there is a picture, controls in steps, and bands behind the curves where inequalities act."""
        scenes = {"arm_of_bodies": 20, "keep_out": 30, "rolled_ball": 30, "through_a_gate": 0, "fastest_stop": 30}
        for scene, stages in scenes.items():
            with self.subTest(scene), tempfile.TemporaryDirectory() as folder:
                self.open(self.control(folder, scene, *([f"horizon.stages={stages}"] if stages else [])))
                has_picture = DRIVER.execute_script("return lagroid.stage !== null")
                self.assertEqual(has_picture, scene != "fastest_stop")
                nothing = DRIVER.find_element("id", "nothing")
                self.assertEqual("no picture in space" in nothing.text, not has_picture)
                if scene == "fastest_stop":
                    self.assertEqual([said[0] for said, _ in DRIVER.execute_script(NAMED)][:2], ["x, m", "v, m/s"])
                if has_picture:
                    stage = DRIVER.find_element("id", "bodies")
                    self.assertTrue(eventually(lambda: colours(stage.screenshot_as_base64) > 20), "the stage is blank")
                self.assertGreater(min(DRIVER.execute_script("return lagroid.plots.points()")), 10)
                # A pixel of a band has its colour, at the top where no curve is, and beside the lines of the grid.
                shaded = """const run = JSON.parse(document.getElementById("run").textContent);
                    return run.panels.flatMap(({ bands }, i) => bands.map(([from, to]) => {
                      const { chart } = lagroid.plots.plots[i];
                      chart.draw();
                      const scale = chart.currentDevicePixelRatio;
                      const x = chart.scales.x.getPixelForValue(from + 0.37 * (to - from));
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
                self.assertEqual(severe(DRIVER), [])

    def test_bands_are_of_their_curves(self):
        """Where a control is at its bound is shaded in its colour; where two are, one above the other."""
        with tempfile.TemporaryDirectory() as folder:
            self.open(self.control(folder, "hovercraft"))
            figure = """const labels = lagroid.plots.plots.map(({ chart }) => chart.data.datasets[0].label);
                const i = labels.indexOf("force");
                const { chart } = lagroid.plots.plots[i];"""
            palette, legend = DRIVER.execute_script(
                figure
                + """const items = [...document.querySelectorAll("figure")[i].querySelectorAll(".legend li")];
                const bands = items.filter((item) => item.querySelector(".band"));
                const shade = (item) => getComputedStyle(item.querySelector(".band")).backgroundColor;
                return [chart.data.datasets.slice(0, 2).map(({ borderColor }) => borderColor),
                        bands.map((item) => [item.innerText, shade(item)])];"""
            )
            said = [text.strip() for text, _ in legend]
            self.assertEqual(said, ["force at its bound, -1.1 or 1.1", "torque at its bound, -0.75 or 0.75"])
            pixel_at = (
                figure
                + """chart.draw();
                const { top, bottom } = chart.chartArea;
                const scale = chart.currentDevicePixelRatio;
                const x = chart.scales.x.getPixelForValue(arguments[0]) * scale;
                const y = (top + arguments[1] * (bottom - top)) * scale;
                return [...chart.ctx.getImageData(x, y, 1, 1).data].slice(0, 3);"""
            )
            # time, share of the height from the top, and whose band is there
            for t, height, curve in ((0.2, 0.04, 1), (0.2, 0.96, 1), (1.26, 0.04, 0), (1.26, 0.96, 1)):
                with self.subTest(t=t, height=height):
                    pixel = DRIVER.execute_script(pixel_at, t, height)
                    self.assertTrue(is_tint(pixel, palette[curve]), f"{pixel} is no light {palette[curve]}")
                    self.assertEqual(legend[curve][1], f"rgb({', '.join(map(str, pixel))})")
            self.assertEqual(DRIVER.execute_script(pixel_at, 0.8, 0.04), [0, 0, 0], "a band where no bound is reached")

    def test_the_picture_follows_the_window(self):
        """Its shape is that of its box, at first and after, and all that moves is in it: on a telephone, too."""
        self.addCleanup(DRIVER.execute_cdp_cmd, "Emulation.clearDeviceMetricsOverride", {})

        def window(width, height, scale):
            size = {"width": width, "height": height, "deviceScaleFactor": scale, "mobile": False}
            DRIVER.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)

        shape = """const { camera, renderer, points } = lagroid.stage;
            const { clientWidth, clientHeight, width, height } = renderer.domElement;
            camera.updateMatrixWorld();
            const seen = points.map((point) => point.clone().project(camera));
            const farthest = Math.max(...seen.flatMap(({ x, y }) => [Math.abs(x), Math.abs(y)]));
            return [camera.aspect, clientWidth / clientHeight, width - clientWidth * devicePixelRatio,
                    height - clientHeight * devicePixelRatio, farthest];"""

        def has_the_shape_of_its_box():
            aspect, box, across, down, farthest = DRIVER.execute_script(shape)
            return abs(aspect - box) < 1e-6 and across == down == 0 and 0.6 < farthest < 1

        with tempfile.TemporaryDirectory() as folder:
            page = page_of(pathlib.Path(folder) / "run", "rolling_disk")
            window(390, 800, 2)
            self.open(page)
            for size in ((390, 800, 2), (1300, 500, 1), (320, 900, 1)):
                with self.subTest(size):
                    window(*size)
                    self.assertTrue(eventually(has_the_shape_of_its_box), DRIVER.execute_script(shape))
                    wider = "return document.documentElement.scrollWidth > innerWidth"
                    self.assertFalse(DRIVER.execute_script(wider), "the page is wider than its window")
            where = "return lagroid.stage.camera.position.toArray()"
            before = DRIVER.execute_script(where)
            DRIVER.find_element("id", "bodies").send_keys(Keys.ARROW_LEFT)
            self.assertNotEqual(DRIVER.execute_script(where), before, "arrow keys turn nothing")

    def test_without_webgl(self):
        """A sentence says what is missing; plots, time and table go on."""
        with tempfile.TemporaryDirectory() as folder:
            page = page_of(pathlib.Path(folder) / "run", "rigid_body")
            driver = browser("disable-gpu", "disable-3d-apis")
            self.addCleanup(driver.quit)
            driver.get(page.as_uri())
            self.assertEqual(severe(driver), [])
            nothing = driver.find_element("id", "nothing")
            self.assertTrue(nothing.is_displayed())
            self.assertIn("WebGL", nothing.text)
            self.assertIn("plots", nothing.text)
            self.assertFalse(driver.find_element("id", "camera").is_displayed())
            self.assertGreater(min(driver.execute_script("return lagroid.plots.points()")), 10)
            self.assertGreater(len(driver.find_elements("css selector", "#ledger tbody td")), 4)
            before = driver.execute_script("return lagroid.player.t")
            self.assertTrue(eventually(lambda: driver.execute_script("return lagroid.player.t") != before))
            self.assertNotEqual(driver.find_element("id", "clock").text, "")
            self.assertGreater(len(driver.find_elements("css selector", "#speed option")), 1)

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
            texts = "return [...document.querySelectorAll('#happened option')].map(({ text }) => text)"
            options = DRIVER.execute_script(texts)
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


def ended_by_the_browser(result):
    """Names of the tests that ended with an error of the browser's own, a tab that crashed or no answer, which says nothing of
    the page: all that did not pass, or none."""
    of_browsers = ("WebDriverException", "TimeoutException", "InvalidSessionIdException", "MaxRetryError", "ProtocolError")
    if result.failures or not all(any(f".{name}: " in trace for name in of_browsers) for _, trace in result.errors):
        return []
    return sorted({getattr(test, "test_case", test).id() for test, _ in result.errors})


def in_a_browser(tests):
    global DRIVER
    DRIVER = browser("use-angle=swiftshader", "enable-unsafe-swiftshader")
    try:
        return unittest.TextTestRunner(verbosity=2).run(tests)
    finally:
        DRIVER.quit()


if __name__ == "__main__":
    load = unittest.defaultTestLoader
    result = in_a_browser(load.loadTestsFromTestCase(Page))
    again = ended_by_the_browser(result)
    if again:
        print("The browser ended on its own: once more in another one.", file=sys.stderr)
        result = in_a_browser(load.loadTestsFromNames([name.removeprefix("__main__.") for name in again], sys.modules["__main__"]))
    sys.exit(not result.wasSuccessful())
