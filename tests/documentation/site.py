"""The built site: site.py FOLDER. Its front page shows what this is, nothing of it needs a network, and with --browser its search
and its switch of versions work when it is opened from files."""
import pathlib
import re
import shutil
import sys
import tempfile
import unittest
import urllib.parse

site = pathlib.Path(sys.argv[1]).resolve()
browser = "--browser" in sys.argv


def references(page):
    """What a page links to, shows or loads: (attribute, target) of files beside it, and of elsewhere."""
    text = re.sub(r"<(pre|code)\b.*?</\1>", "", page.read_text(), flags=re.S)
    return [(name, target.split("#")[0].split("?")[0]) for name, target in re.findall(r'\b(src|href)="([^"]+)"', text)]


def missing(page):
    """Files that a page refers to and that are not there, and what it would load from elsewhere."""
    for name, target in references(page):
        if urllib.parse.urlsplit(target).scheme:
            if name == "src":
                yield target
        elif target and not (page.parent / urllib.parse.unquote(target)).exists():
            yield target


class Site(unittest.TestCase):
    def test_front_page_shows_what_this_is(self):
        text = (site / "docs/index.html").read_text()
        main = text.split('role="main"')[1]
        self.assertIn('src="../_images/motion.svg"', main)
        shown = [re.sub(r"<[^>]+>", "", block) for block in re.findall(r"<pre>(.*?)</pre>", main, re.S)]
        code, ledger = (next(block for block in shown if word in block) for word in ("struct", "ledger"))
        self.assertLess(len(code.splitlines()), 30)
        self.assertGreaterEqual(ledger.count(": kept"), 2)
        self.assertLess(main.count("<li"), 5)  # no list of links
        self.assertIn('href="docs/index.html"', (site / "index.html").read_text())

    def test_front_and_search_need_nothing_from_elsewhere(self):
        for name in ("docs/index.html", "docs/architecture.html", "docs/api/core.html", "search.html"):
            self.assertEqual(list(missing(site / name)), [], name)
        self.assertIn("vakonom", (site / "searchindex.js").read_text())

    def test_versions_are_listed(self):
        self.assertRegex((site / "versions.js").read_text(), r'\Aconst siteVersions = \[\{name: "newest", folder: ""\}')

    def test_lessons_have_their_scene_and_where_there_is_one_their_laboratory(self):
        pages = sorted((site / "docs/lessons").glob("[0-9]*.html"))
        self.assertEqual(len(pages), 12)
        for page in pages:
            text = page.read_text()
            self.assertRegex(text, r'href="[^"]*source/docs/lessons/scenes/\w+\.toml\.html"')
            frames = re.findall(r'data-page="([^"#]+)#', text)
            self.assertEqual(len(frames), 1 if (site / "laboratory").exists() else 0, page.name)
            self.assertTrue(all((page.parent / frame).exists() for frame in frames))

    def test_a_missing_file_is_found_out(self):
        with tempfile.TemporaryDirectory() as folder:
            page = pathlib.Path(folder) / "page.html"
            page.write_text('<a href="none.html#a">a</a><script src="https://x.org/y.js"></script><a href="https://x.org">b</a>')
            self.assertEqual(list(missing(page)), ["none.html", "https://x.org/y.js"])


@unittest.skipUnless(browser, "without --browser")
class Browser(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        from selenium import webdriver

        options = webdriver.ChromeOptions()
        for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage"):
            options.add_argument(argument)
        cls.driver = webdriver.Chrome(options=options)

    @classmethod
    def tearDownClass(cls):
        cls.driver.quit()

    def waits_for(self, script, *arguments):
        from selenium.webdriver.support.ui import WebDriverWait

        return WebDriverWait(self.driver, 60).until(lambda driver: driver.execute_script(script, *arguments))

    def test_search_finds_from_files(self):
        found = "return document.querySelectorAll('#search-results li a').length"
        self.driver.get((site / "search.html").as_uri() + "?q=vakonomic")
        self.assertGreater(self.waits_for(found), 0)

    def test_switch_leads_to_the_other_version(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name) / "site"
            shutil.copytree(site, folder, ignore=shutil.ignore_patterns("source", ".sphinx", "_images"))
            (folder / "versions.js").write_text(
                'const siteVersions = [{name: "newest", folder: ""}, {name: "v0.1.0", folder: "versions/v0.1.0/"}];\n')
            for page, target in (("docs/index.html", "docs/index.html"), ("docs/theory/G.html", "docs/index.html")):
                self.driver.get((folder / page).as_uri())
                links = self.driver.execute_script(
                    "return [...document.querySelectorAll('#site-versions dd a')].map((link) => link.href)")
                self.assertEqual(links, [(folder / target).as_uri(), (folder / "versions/v0.1.0" / target).as_uri()])
                self.assertFalse(self.driver.execute_script("return document.getElementById('site-versions').hidden"))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])
