"""Links of all Markdown pages lead to files, folders and headings that exist; with --network, somebody answers elsewhere."""
import re
import sys
import unittest
import urllib.error
import urllib.parse
import urllib.request

from pages import Page, pages, root

network = "--network" in sys.argv


def targets(page):
    for line, token in page.inlines():
        if token.type == "link_open":
            yield line, token.attrs["href"]
        elif token.type == "image":
            yield line, token.attrs["src"]


def broken_links(page):
    """What its links miss, each as page:line: target: why."""
    for line, target in targets(page):
        where = f"{page.name}:{line}: {target}"
        if re.match(r"[a-z]+:", target):
            parts = urllib.parse.urlsplit(target)
            if parts.scheme not in ("https", "http", "mailto") or not (parts.netloc or parts.path):
                yield f"{where}: no address"
            continue
        path, _, anchor = target.partition("#")
        file = (page.path.parent / path).resolve() if path else page.path
        if file != page.path and not file.exists():
            yield f"{where}: no such file"
        elif not file.is_relative_to(root):
            yield f"{where}: outside of the project"
        elif anchor and anchor not in (page if file == page.path else Page(file, file.read_text())).anchors():
            yield f"{where}: no such heading"


def gone(address):
    """Why nobody answers there; empty where somebody does, be it with a refusal of programs."""
    try:
        request = urllib.request.Request(address, headers={"User-Agent": "lagroid-links"})
        with urllib.request.urlopen(request, timeout=20):
            return ""
    except urllib.error.HTTPError as error:
        return f"{address}: {error}" if error.code in (404, 410) else ""
    except OSError as error:
        return f"{address}: {error}"


class Links(unittest.TestCase):
    def test_lead_somewhere(self):
        self.assertEqual([broken for page in pages() for broken in broken_links(page)], [])

    def test_that_lead_nowhere_are_found_out(self):
        page = Page(root / "docs" / "page.md", "# A b\n[1](nothing.md) [2](#a-b) [3](#c) [4](notation.md#nothing) "
                    "[5](ftp://x) [6](../README.md) [7](https://x.org)")
        self.assertEqual([broken.split(": ")[1] for broken in broken_links(page)],
                         ["nothing.md", "#c", "notation.md#nothing", "ftp://x"])

    @unittest.skipUnless(network, "without --network")
    def test_to_elsewhere_are_answered(self):
        addresses = {target for page in pages() for _, target in targets(page) if target.startswith("http")}
        missing = [why for why in map(gone, sorted(addresses)) if why]
        if addresses and len(missing) == len(addresses):
            self.skipTest("no network")
        self.assertEqual(missing, [])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])
