"""Chromium without a window, and the addresses of the page."""
import base64
import json
import time

from selenium import webdriver


def driver():
    options = webdriver.ChromeOptions()
    for flag in ("headless=new", "no-sandbox", "disable-dev-shm-usage", "use-angle=swiftshader",
                 "enable-unsafe-swiftshader", "window-size=1200,900"):
        options.add_argument(f"--{flag}")
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(options=options)


def eventually(holds, seconds=60):
    """Whether it holds within that time: a busy machine is slow."""
    end = time.monotonic() + seconds
    while not holds():
        if time.monotonic() > end:
            return False
        time.sleep(0.05)
    return True


def fragment(**state):
    """What an address has of a page's state (web/page/link.js)."""
    text = json.dumps({"settings": [], "first": "", "second": None, **state})
    return "#" + base64.urlsafe_b64encode(text.encode()).decode().rstrip("=")


def links(count):
    """A scene: a chain of so many pendulums, let go from the side."""
    return f"""system = "pendulum_chain"
[parameters]
masses = {[1.0] * count}
lengths = {[1.0 / count] * count}
gravity = 9.81
[initial]
theta = {[1.6] * count}
phi = {[0.0] * count}
[time]
step = 0.001
steps = 20000
"""


def frames(browser):
    """Milliseconds of the page's own work in the last frames that it drew."""
    return browser.execute_script("return lagroid.frames")
