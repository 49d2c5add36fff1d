#!/usr/bin/python3
"""The lessons' laboratories: each scene in the page's engine ends as by the program, and each page of the site runs its own
with the verdicts that the lesson states.

lessons.py LAGROID GLUE [SITE]      without a site, in node alone
"""
import functools
import http.server
import json
import pathlib
import subprocess
import sys
import threading
import time
import tomllib
import unittest

root = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(root / "tests/documentation"))
import lessons  # noqa: E402

GLUE, SITE = pathlib.Path(sys.argv[2]).resolve(), pathlib.Path(sys.argv[3]).resolve() if len(sys.argv) > 3 else None
RUN = pathlib.Path(__file__).with_name("run_scene.mjs")


def in_engine(scene, settings):
    run = subprocess.run(["node", RUN, GLUE, scene, *settings], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr[-500:]
    return json.loads(run.stdout)


def ends(summary):
    return [summary["final"]["time"], *summary["final"].get("position", []), *summary["final"].get("momentum", [])]


def apart(one, other):
    return max(abs(a - b) for a, b in zip(ends(one), ends(other), strict=True))


def allowed(scene, settings, end):
    """How far apart two runs may end by round-off: a walk of roundings, grown as the motion makes grow a change of the start."""
    share = 1e-12  # small, for in chaos what is larger does not grow all the way
    initial = tomllib.loads(scene.read_text())["initial"]
    key, start = next((key, initial[key]) for key in ("position", "velocity", "momentum") if any(initial.get(key, [])))
    at = max(range(len(start)), key=lambda i: abs(start[i]))
    changed = [value * (1 + share) if i == at else value for i, value in enumerate(start)]
    other = lessons.summary(scene, [*settings, f"initial.{key}={changed}"])
    growth = max(1, apart(end, other) / (share * abs(start[at])))
    weight = 200 if "controlled" in end["method"] else 20  # sizes of steps are sums of small differences
    return 2**-53 * max(map(abs, ends(end))) * growth * weight * (10 + end["steps"] ** 0.5)


class InTheEngine(unittest.TestCase):
    def test_scenes_end_as_by_the_program(self):
        for page in lessons.lessons():
            for column, scene, settings in lessons.methods_of(page):
                with self.subTest(page.name, method=column):
                    ours, native = in_engine(scene, settings), lessons.summary(scene, settings)
                    self.assertEqual((ours["status"], ours["steps"]), (native["status"], native["steps"]))
                    self.assertEqual(lessons.verdicts(ours), lessons.verdicts(native))
                    if native.get("cost"):
                        self.assertAlmostEqual(ours["cost"], native["cost"], delta=1e-9 * native["cost"])
                    else:
                        self.assertLess(apart(ours, native), allowed(scene, settings, native))


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


@unittest.skipUnless(SITE, "without a site")
class InTheSite(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        from selenium import webdriver

        options = webdriver.ChromeOptions()
        for flag in ("headless=new", "no-sandbox", "disable-dev-shm-usage", "window-size=1300,1000"):
            options.add_argument(f"--{flag}")
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        cls.driver = webdriver.Chrome(options=options)
        cls.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=SITE))
        threading.Thread(target=cls.server.serve_forever, daemon=True).start()

    @classmethod
    def tearDownClass(cls):
        cls.driver.quit()
        cls.server.shutdown()

    def eventually(self, holds, seconds=60):
        end = time.monotonic() + seconds
        while not holds():
            self.assertLess(time.monotonic(), end, self.refusal())
            time.sleep(0.05)

    def refusal(self):
        return self.driver.find_element("id", "refusal").text

    def ready(self):
        return self.driver.execute_script("return !!window.lagroid && lagroid.places.size > 0")

    def run_to_the_end(self):
        """What the ledger says in the end, method by method."""
        self.eventually(self.ready)
        if self.driver.find_element("id", "run").is_enabled():
            self.driver.find_element("id", "run").click()
        self.eventually(lambda: self.driver.execute_script(
            "return [...lagroid.places.values()].every(({ goes_on }) => !goes_on)"))
        return self.driver.execute_script("""return [...lagroid.places].sort(([a], [b]) => a - b).map(([, { summary }]) =>
            Object.fromEntries(summary.ledger.entries.map(({ name, verdict }) => [name, verdict])));""")

    def mistakes(self):
        return [entry for entry in self.driver.get_log("browser")
                if entry["level"] == "SEVERE" and "favicon" not in entry["message"]]

    def test_lessons_run_in_their_pages(self):
        for page in lessons.lessons():
            for base in (f"http://127.0.0.1:{self.server.server_port}", SITE.as_uri()):  # from a server, and from files
                with self.subTest(page.name, base=base.split(":")[0]):
                    self.driver.get("about:blank")
                    self.driver.get(f"{base}/docs/lessons/{page.path.stem}.html")
                    frame = self.driver.find_element("css selector", "iframe.laboratory")
                    self.driver.execute_script("arguments[0].scrollIntoView()", frame)
                    self.driver.switch_to.frame(frame)
                    self.assertEqual(self.run_to_the_end(), list(lessons.verdicts_stated(page.text).values()))
                    self.assertEqual(self.mistakes(), [])

    def test_the_gallery_leads_to_scenes_that_run(self):
        self.driver.get((SITE / "docs/gallery.html").as_uri())
        links = [link.get_attribute("href") for link in self.driver.find_elements("css selector", "a.laboratory")]
        self.assertGreater(len(links), 15)
        for link in links:
            self.driver.get("about:blank")
            self.driver.get(link)
            self.eventually(self.ready)
            self.assertEqual(self.refusal(), "")
            self.assertEqual(self.mistakes(), [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
