#!/usr/bin/python3
"""The laboratory of the browser, opened from a disk and, as a site, from a folder: it runs, keeps what the program keeps,
and takes what others wrote as text.

page.py FOLDER EXAMPLES LAGROID AXE [TEST...]
"""
import base64
import functools
import http.server
import json
import pathlib
import subprocess
import sys
import tempfile
import threading
import time
import unittest

from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select

from browser import driver, eventually, fragment, frames, links

FOLDER, EXAMPLES, LAGROID, AXE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3], pathlib.Path(sys.argv[4])


def native_verdicts(scene):
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([LAGROID, "run", EXAMPLES / f"{scene}.toml", "--out", f"{folder}/run"], check=True,
                       capture_output=True)
        summary = json.loads((pathlib.Path(folder) / "run/summary.json").read_text())
    return {entry["name"]: entry["verdict"] for entry in summary["ledger"]["entries"]}


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


class Page(unittest.TestCase):
    def open(self, address):
        DRIVER.get("about:blank")
        DRIVER.get(address)
        self.assertTrue(eventually(lambda: self.find("run").is_enabled()), self.find("refusal").text)

    def tearDown(self):
        self.assertEqual([entry for entry in DRIVER.get_log("browser") if entry["level"] == "SEVERE"], [])

    def find(self, name):
        return DRIVER.find_element("id", name)

    def steps(self):
        return DRIVER.execute_script("return lagroid.places.get(0)?.summary.steps ?? -1")

    def ended(self):
        return DRIVER.execute_script(
            "return lagroid.places.size > 0 && [...lagroid.places.values()].every(({ goes_on }) => !goes_on)")

    def ledger(self):
        return DRIVER.execute_script("""return [...document.getElementById("ledger").rows].map((row) =>
            [...row.cells].map((cell) => cell.textContent));""")

    def one_file(self, **state):
        self.open((FOLDER / "lagroid.html").as_uri() + (fragment(**state) if state else ""))

    def test_scenes_end_with_the_verdicts_of_the_program(self):
        self.one_file()
        for scene in ("pendulum", "kepler_order_8"):
            with self.subTest(scene):
                Select(self.find("scenes")).select_by_value(scene)
                self.assertTrue(eventually(lambda: self.steps() == 0 and self.find("run").is_enabled()))
                self.find("run").send_keys(Keys.ENTER)
                self.assertTrue(eventually(self.ended))
                expected = native_verdicts(scene)
                self.assertTrue(eventually(lambda: {row[1]: row[5] for row in self.ledger()} == expected), self.ledger())

    def test_a_method_that_drifts_turns_red_beside_ours(self):
        self.one_file(scene=(EXAMPLES / "kepler.toml").read_text(), settings=[["time.steps", "20000"]])
        self.assertTrue(eventually(lambda: len(Select(self.find("second")).options) > 2))
        worse = next(option.get_attribute("value") for option in Select(self.find("second")).options
                     if "unge" in option.text)
        Select(self.find("second")).select_by_value(worse)
        self.assertTrue(eventually(lambda: DRIVER.execute_script("return lagroid.places.size") == 2))
        self.find("run").click()
        self.assertTrue(eventually(self.ended))
        self.assertTrue(eventually(lambda: len(self.ledger()) > 2))
        red = DRIVER.find_elements("css selector", "#ledger .BROKEN, #ledger .growing")
        self.assertTrue(red, self.ledger())

    def test_at_the_same_cost(self):
        self.one_file(scene=(EXAMPLES / "kepler.toml").read_text(), settings=[["time.steps", "3000"]], fair=True,
                      second="variational/kahan-li-8")
        self.assertTrue(eventually(lambda: DRIVER.execute_script("return lagroid.places.size") == 2))
        self.assertTrue(self.find("fair").is_selected())
        asked = DRIVER.execute_script("return [0, 1].map((at) => lagroid.places.get(at).summary.steps_asked)")
        # Seventeen stages a step take longer than one, whatever the machine.
        self.assertLess(asked[1], asked[0])
        self.find("run").click()
        self.assertTrue(eventually(self.ended))
        ends = DRIVER.execute_script("return [0, 1].map((at) => lagroid.places.get(at).summary.final.time)")
        self.assertAlmostEqual(ends[0], ends[1], places=9)
        self.find("fair").click()
        self.assertTrue(eventually(lambda: DRIVER.execute_script(
            "return lagroid.places.get(1)?.summary.steps_asked ?? 0") == asked[0]))

    def test_pause_step_and_sliders(self):
        self.one_file(scene=(EXAMPLES / "pendulum.toml").read_text(), settings=[["time.steps", "10000000"]])
        self.find("run").click()
        self.assertTrue(eventually(lambda: self.steps() > 100))
        self.find("run").click()
        self.assertEqual(self.find("run").text, "Run")
        time.sleep(0.5)
        at = self.steps()
        time.sleep(0.5)
        self.assertEqual(self.steps(), at, "it goes on while paused")
        self.find("step").click()
        self.assertTrue(eventually(lambda: self.steps() == at + 1))
        DRIVER.execute_script("""const slider = document.querySelector("#turned input[type=range]");
            slider.value = slider.max; slider.dispatchEvent(new Event("input"));""")
        self.assertTrue(eventually(lambda: 0 < self.steps() != at + 1))
        self.assertIn("parameters.mass", base64.urlsafe_b64decode(
            DRIVER.execute_script("return location.hash.slice(1)") + "===").decode())

    def state(self):
        return DRIVER.execute_script("return {settings: Object.fromEntries(lagroid.state.settings)}")["settings"]

    def test_bodies_and_formulas(self):
        self.one_file()
        offered = {option.text for option in Select(self.find("scenes")).options}
        self.assertLessEqual({"six_bar", "tumbling_book", "pendulum_chain", "plate_ball", "elastic_pendulum"}, offered)
        self.assertNotIn("learned_hamiltonian", offered)
        for scene, slider in (("six_bar", "stiffness"), ("elastic_pendulum", "k")):
            with self.subTest(scene):
                Select(self.find("scenes")).select_by_value(scene)
                self.assertTrue(eventually(lambda: self.steps() == 0 and self.find("run").is_enabled()))
                self.assertTrue(eventually(lambda: slider in self.find("turned").text), self.find("turned").text)
                self.find("run").click()
                self.assertTrue(eventually(self.ended))
                expected = native_verdicts(scene)
                self.assertTrue(eventually(lambda: {row[1]: row[5] for row in self.ledger()} == expected), self.ledger())

    def test_a_lagrangian_of_the_readers_own(self):
        self.one_file()
        Select(self.find("scenes")).select_by_value("your own Lagrangian")
        self.assertTrue(eventually(lambda: self.steps() == 0 and "length" in self.find("turned").text))
        editor = self.find("editor")
        self.assertTrue(editor.is_displayed())
        # A cart on a spring: x keeps no momentum any more, and the stiffness has its slider.
        DRIVER.execute_script("""const [editor] = arguments;
            editor.value = editor.value.replace('cos(theta)"', 'cos(theta) - k/2*x^2"').replace("M = 2.0", "M = 2.0\\nk = 20.0");
            editor.dispatchEvent(new Event("change"));""", editor)
        self.assertTrue(eventually(lambda: "\nk\n" in self.find("turned").text), self.find("refusal").text)
        self.find("run").click()
        self.assertTrue(eventually(self.ended))
        self.assertTrue(eventually(lambda: {row[1]: row[5] for row in self.ledger()}["energy"] == "bounded"), self.ledger())

    def test_the_cheapest_way_to_roll_a_ball(self):
        self.one_file(scene=(EXAMPLES / "plate_ball.toml").read_text())
        paths = lambda: DRIVER.find_elements("css selector", "#paths button")
        self.assertTrue(eventually(lambda: len(paths()) > 2), self.find("refusal").text)
        self.assertEqual([path.get_attribute("aria-pressed") for path in paths()[:2]], ["true", "false"])
        cost = lambda: DRIVER.execute_script("return lagroid.places.get(0)?.summary.cost ?? 0")
        cheapest = cost()
        paths()[1].click()
        self.assertTrue(eventually(lambda: cost() > cheapest))
        self.assertEqual(self.state()["solver.path"], "2")
        DRIVER.execute_async_script("requestAnimationFrame(() => requestAnimationFrame(arguments[0]))")
        # Both ends are handles in the picture of the plane.
        canvas = DRIVER.find_element("css selector", "figure canvas.movable")
        place = DRIVER.execute_script("""const plot = lagroid.plots().find(({handles}) => handles.length > 0);
            const end = plot.handles.find(({name}) => name === "boundary.end.position");
            const [x, y] = plot.at(end.x, end.y);
            return [x - plot.canvas.clientWidth / 2, y - plot.canvas.clientHeight / 2];""")
        ActionChains(DRIVER).move_to_element_with_offset(canvas, *map(round, place)).click_and_hold() \
            .move_by_offset(-40, 20).release().perform()
        self.assertTrue(eventually(lambda: "boundary.end.position" in self.state()), self.state())
        self.assertTrue(eventually(lambda: cost() != cheapest and len(paths()) > 0))

    def test_what_accuracy_costs(self):
        self.one_file(scene=(EXAMPLES / "kepler.toml").read_text(), settings=[["time.steps", "600"]])
        self.find("measure").click()
        points = "return [...(lagroid.study.points ?? new Map()).values()].map((each) => each.map(({error}) => error))"
        measured = lambda: [errors for errors in DRIVER.execute_script(points) if len(errors) > 2]
        # A run more of each, until somebody has a billionth.
        self.assertTrue(eventually(lambda: len(measured()) > 2 and min(map(min, measured())) < 1e-9, 200), measured())
        self.assertTrue(DRIVER.find_elements("css selector", "#study canvas"))

    def test_completion(self):
        self.one_file(scene='system = "pendulum"\n\n[time]\n')
        DRIVER.execute_script("document.querySelector('details').open = true")
        editor = self.find("editor")
        editor.click()
        editor.send_keys(Keys.CONTROL, Keys.END)
        offers = lambda: [button.text for button in DRIVER.find_elements("css selector", "#offers button")]
        self.assertTrue(eventually(lambda: "duration" in offers()), offers())
        editor.send_keys("mo")
        self.assertTrue(eventually(lambda: offers() == ["mode"]), offers())
        DRIVER.find_element("css selector", "#offers button").click()
        editor.send_keys('"pre')
        self.assertTrue(eventually(lambda: "adaptive" not in offers()), offers())
        self.assertTrue(editor.get_attribute("value").endswith('mode = "pre'))

    def test_phase_plots_and_sections(self):
        scene = (EXAMPLES / "pendulum.toml").read_text()
        self.one_file(scene=scene)
        self.assertTrue(eventually(lambda: self.find("views").is_displayed()))
        field = lambda name: self.find("views").find_element("name", name)
        ask = lambda kind: field("phase").click() if kind == "phase" else field("value").send_keys(Keys.ENTER)
        captions = lambda: DRIVER.execute_script(
            "return [...document.querySelectorAll('#added figcaption')].map((each) => each.textContent)")
        Select(field("x")).select_by_value("q")
        Select(field("y")).select_by_value("p")
        ask("phase")
        self.assertTrue(eventually(lambda: captions() == ["p over q"]), captions())
        self.assertEqual(self.steps(), 0)
        self.find("run").click()
        self.assertTrue(eventually(self.ended))
        Select(field("direction")).select_by_value("falling")
        field("value").clear()
        field("value").send_keys("0.25")
        ask("section")
        name = "p over q where q falls through 0.25"
        self.assertTrue(eventually(lambda: captions() == ["p over q", name] and self.ended()), self.find("refusal").text)
        points = lambda: DRIVER.execute_script("const {columns} = lagroid.places.get(0).sections[0];"
                                               "return [Array.from(columns.q), Array.from(columns.p)];")
        event = f'\n[[event]]\nname = "bottom"\nwhen = "q - 0.25"\ndirection = "falling"\n'
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "scene.toml").write_text(scene + event)
            subprocess.run([LAGROID, "run", f"{folder}/scene.toml", "--out", f"{folder}/run"], check=True, capture_output=True)
            events = json.loads((pathlib.Path(folder) / "run/summary.json").read_text())["events"]
        expected = [row["values"] for row in events["rows"]]
        self.assertGreater(len(expected), 3)
        q, p = (events["columns"].index(column) for column in "qp")
        for found, place in zip(points(), (q, p)):
            self.assertEqual(len(found), len(expected))
            for one, other in zip(found, expected):
                self.assertAlmostEqual(one, other[place], places=10)
        # The pixels of a curve and of points are there.
        for canvas in DRIVER.find_elements("css selector", "#added canvas"):
            self.assertGreater(DRIVER.execute_script("""const [canvas] = arguments;
                const {data} = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
                let blue = 0;
                for (let i = 0; i < data.length; i += 4) blue += data[i + 3] > 200 && data[i + 2] > data[i] + 80;
                return blue;""", canvas), 3)
        # A phase plot has every row, and is drawn without a run from the start.
        last = lambda: DRIVER.execute_script("return Array.from(lagroid.places.get(0).last.q)")
        self.assertEqual(len(last()), self.steps() + 1)
        # A second method has its own points; the link has it all.
        method = Select(self.find("second")).options[-1].get_attribute("value")
        Select(self.find("second")).select_by_value(method)
        self.assertTrue(eventually(lambda: DRIVER.execute_script("return lagroid.places.get(1)?.sections.length") == 1))
        self.open(DRIVER.current_url)
        self.assertTrue(eventually(lambda: captions() == ["p over q", name]), self.find("refusal").text)
        DRIVER.find_element("css selector", f"#added button[aria-label='Remove {name}']").click()
        self.assertTrue(eventually(lambda: captions() == ["p over q"]), captions())
        Select(self.find("scenes")).select_by_value("kepler")
        self.assertTrue(eventually(lambda: captions() == []), captions())

    def test_sections_that_cannot_be(self):
        pendulum = (EXAMPLES / "pendulum.toml").read_text()
        section = lambda column, value, x="q": {"x": x, "y": "p", "through": {
            "column": column, "value": value, "direction": "rising"}}
        views = lambda: DRIVER.execute_script("return lagroid.state.views")
        figures = lambda: DRIVER.execute_script("return document.querySelectorAll('#plots figure').length")
        # What the run refuses is told, and only that is taken away.
        for column in ("drift energy", "nothing", "1 )"):
            with self.subTest(column):
                self.one_file(scene=pendulum, views=[section("q", "0.25"), section(column, "1")])
                self.assertTrue(eventually(lambda: self.steps() == 0 and len(views()) == 1), self.find("refusal").text)
                self.assertTrue(self.find("refusal").is_displayed())
                self.assertTrue(eventually(lambda: figures() > 0))
        # Times are those of the points; a column that is the same in all points is a line, and no page without an end.
        self.one_file(scene=pendulum, views=[section("q", "0.25", "t"), section("p", "0.25")])
        self.assertTrue(eventually(lambda: self.steps() == 0))
        self.find("run").click()
        self.assertTrue(eventually(self.ended))
        times, constant = DRIVER.execute_script(
            "return lagroid.places.get(0).sections.map(({columns}) => Array.from(columns.t ?? columns.p)).map((all) => all.sort((a, b) => a - b))")
        self.assertTrue(all(0 < before < after < 100 for before, after in zip(times, times[1:])), times)
        self.assertLess(constant[-1] - constant[0], 1e-9)
        self.assertTrue(eventually(lambda: "converged" in self.find("status").text), self.find("status").text)
        # Between ends that are given nothing is watched for.
        self.one_file(scene=(EXAMPLES / "plate_ball.toml").read_text())
        self.assertTrue(eventually(lambda: self.find("views").is_displayed()))
        self.assertFalse(self.find("through").is_displayed())
        # A link without its end says so.
        DRIVER.get("about:blank")
        self.open((FOLDER / "lagroid.html").as_uri() + fragment(scene=pendulum)[:-40])
        self.assertTrue(eventually(lambda: "link" in self.find("refusal").text))

    def test_files_to_take_along(self):
        self.one_file(scene=(EXAMPLES / "tumbling_book.toml").read_text(), settings=[["time.steps", "50"]])
        DRIVER.execute_cdp_cmd("Browser.setDownloadBehavior", {"behavior": "deny"})
        DRIVER.execute_script("""window.saved = [];
            const place = URL.createObjectURL.bind(URL);
            URL.createObjectURL = (blob) => (saved.push([blob.type, blob.size]), place(blob));""")
        self.find("run").click()
        self.assertTrue(eventually(self.ended))
        self.assertTrue(eventually(lambda: self.find("stage").is_displayed()))
        for button in ("export", "save", "png", "webm"):
            self.find(button).click()
        saved = lambda: dict(DRIVER.execute_script("return saved"))
        self.assertTrue(eventually(lambda: len(saved()) == 4), [saved(), self.find("refusal").text])
        self.assertEqual(set(saved()), {"text/csv", "application/toml", "image/png", "video/webm"})
        self.assertGreater(min(saved().values()), 100)

    def test_a_frame_is_short(self):
        """The quickest is judged: others wait for whatever else the machine does."""
        self.one_file(scene=links(20))
        self.find("run").click()
        self.assertTrue(eventually(lambda: len(frames(DRIVER)) > 5))
        self.assertLess(min(frames(DRIVER)), 8)
        self.find("run").click()
        self.assertTrue(eventually(lambda: self.find("animate").is_displayed()))
        self.find("animate").click()
        self.assertTrue(eventually(lambda: len(frames(DRIVER)) > 30, 120))
        self.assertLess(min(frames(DRIVER)), 8)

    def test_accessibility(self):
        self.one_file()
        self.assertTrue(eventually(lambda: len(self.ledger()) > 0))
        DRIVER.execute_script((AXE / "axe.min.js").read_text())
        found = DRIVER.execute_async_script("axe.run().then(({violations}) => arguments[arguments.length - 1](violations))")
        serious = [(each["id"], each["nodes"][0]["html"]) for each in found if each["impact"] in ("serious", "critical")]
        self.assertEqual(serious, [])

    def test_mistakes_and_hostile_text(self):
        self.one_file(scene='system = "pendulum"\n[time]\nstep = 0.1\nsteps = "<img src=x onerror=alert(1)>"\n')
        self.assertTrue(eventually(lambda: "line 4: time.steps" in self.find("refusal").text), self.find("refusal").text)
        self.one_file(scene='system = "<script>alert(1)</script>"\n')
        self.assertTrue(eventually(lambda: self.find("refusal").is_displayed()))
        self.assertEqual(DRIVER.find_elements("css selector", "body img, #refusal script"), [])
        view = {"x": "<img src=x onerror=alert(1)>", "y": "p", "through": {"column": '"\n[x]', "value": "1", "direction": "up"}}
        self.one_file(scene=(EXAMPLES / "pendulum.toml").read_text(), views=[view, {"x": view["x"], "y": "p"}])
        self.assertTrue(eventually(lambda: "a section: event.0" in self.find("refusal").text), self.find("refusal").text)
        self.assertTrue(eventually(lambda: self.steps() == 0))  # without it
        self.one_file(scene=(EXAMPLES / "pendulum.toml").read_text(), views=[{"x": view["x"], "y": "p"}])
        self.assertTrue(eventually(lambda: "<img" in self.find("added").text))
        self.assertEqual(DRIVER.find_elements("css selector", "body img"), [])

    def test_what_takes_too_long_is_given_up(self):
        self.one_file(scene=(EXAMPLES / "kepler_boundary.toml").read_text(),
                      settings=[["time.steps", "20000"], ["solver.starts", "100000"]])
        time.sleep(4)
        self.assertEqual(self.steps(), -1)
        Select(self.find("scenes")).select_by_value("pendulum")
        self.assertTrue(eventually(lambda: self.steps() == 0, 20))

    def test_a_narrow_screen(self):
        DRIVER.set_window_size(500, 800)
        DRIVER.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                               {"width": 375, "height": 700, "deviceScaleFactor": 1, "mobile": True})
        try:
            self.one_file()
            self.assertTrue(eventually(lambda: len(self.ledger()) > 0))
            self.assertLessEqual(DRIVER.execute_script("return document.documentElement.scrollWidth"), 375)
        finally:
            DRIVER.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
            DRIVER.set_window_size(1200, 900)

    def test_the_site(self):
        handler = functools.partial(Quiet, directory=FOLDER)
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        try:
            self.open(f"http://127.0.0.1:{server.server_port}/index.html")
            self.find("run").click()
            self.assertTrue(eventually(self.ended))
        finally:
            server.shutdown()


if __name__ == "__main__":
    DRIVER = driver()
    try:
        unittest.main(argv=[sys.argv[0], *sys.argv[5:]], verbosity=2)
    finally:
        DRIVER.quit()
