#!/usr/bin/python3
"""The laboratory of the browser, opened from a disk and, as a site, from a folder: it runs, keeps what the program keeps,
and takes what others wrote as text.

page.py FOLDER EXAMPLES LAGROID
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

from selenium import webdriver
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select

FOLDER, EXAMPLES, LAGROID = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]


def eventually(holds, seconds=60):
    """Whether it holds within that time: a busy machine is slow."""
    end = time.monotonic() + seconds
    while not holds():
        if time.monotonic() > end:
            return False
        time.sleep(0.05)
    return True


def fragment(**state):
    text = json.dumps({"settings": [], "first": "", "second": None, **state})
    return "#" + base64.urlsafe_b64encode(text.encode()).decode().rstrip("=")


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

    def test_mistakes_and_hostile_text(self):
        self.one_file(scene='system = "pendulum"\n[time]\nstep = 0.1\nsteps = "<img src=x onerror=alert(1)>"\n')
        self.assertTrue(eventually(lambda: "line 4: time.steps" in self.find("refusal").text), self.find("refusal").text)
        self.one_file(scene='system = "<script>alert(1)</script>"\n')
        self.assertTrue(eventually(lambda: self.find("refusal").is_displayed()))
        self.assertEqual(DRIVER.find_elements("css selector", "body img, #refusal script"), [])

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
