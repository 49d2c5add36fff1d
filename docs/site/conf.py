"""The documentation site: the Markdown pages as they stand, and the API reference. `./lagroid docs` builds it."""
import os
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
root = pathlib.Path(__file__).parents[2]

project = "Lagroid"
release = re.search(r"^## ([\d.]+)", (root / "CHANGELOG.md").read_text(), re.M)[1]
version = release
language = "en"

extensions = ["myst_parser", "api", "laboratory", "links", "mathml", "notebooks"]
include_patterns = ["*.md", "docs/**.md", "python/notebooks/*.ipynb"]
exclude_patterns = ["build", "out", ".git"]
root_doc = "docs/index"

myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
highlight_language = "text"

html_theme = "sphinx_rtd_theme"
html_title = f"Lagroid {release}"
html_math_renderer = "mathml"
html_static_path = ["site.css", "laboratory.js"]
# The switch of versions (templates/versions.html): which one this is, and where from its pages the newest one's lie.
release_of_site = os.environ.get("LAGROID_SITE_VERSION")
templates_path = ["templates"]
html_context = {"site_version": release_of_site or "newest", "site_top": "../../" if release_of_site else ""}
html_css_files = ["site.css"]
html_extra_path = ["index.html"]
html_show_sphinx = False
html_show_copyright = False
html_copy_source = False
