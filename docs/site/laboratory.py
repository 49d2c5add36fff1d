"""Laboratories in the pages: a paragraph that is a link "Laboratory: WHAT, beside METHOD" to a scene becomes the page of
`./lagroid web` with that scene in it, and every picture of the gallery whose scene runs there gets a "run it here".

Which scenes run is asked of the engine itself. Where there is none, or no node to ask it, links to the scenes are left."""
import base64
import json
import pathlib
import re
import shutil
import subprocess

from docutils import nodes
from sphinx import addnodes
from sphinx.transforms import SphinxTransform
from sphinx.util import logging

import gallery
from links import link_to_source

root = pathlib.Path(__file__).resolve().parents[2]
web = root / "build/web"
glue = root / "build/wasm/web/lagroid_web.js"
described = re.compile(r"Laboratory: (?P<what>.*?)(?:, beside (?P<second>\S+))?$")


def fragment(scene, settings=(), second=None):
    """What the page has in its address (web/page/link.js)."""
    state = {"scene": scene, "settings": [setting.split("=", 1) for setting in settings], "first": "", "second": second}
    return "#" + base64.urlsafe_b64encode(json.dumps(state).encode()).decode().rstrip("=")


def ask_engine(scenes):
    """{version, refused: why each of the pairs of scene and settings does not run, or None}; None without an engine, or with
    one that the sources have left behind."""
    if not (web / "index.html").exists() or not glue.exists() or not shutil.which("node"):
        return None
    asked = [{"scene": scene, "settings": list(settings)} for scene, settings in scenes]
    done = subprocess.run(["node", pathlib.Path(__file__).with_name("runs_here.mjs"), glue], input=json.dumps(asked),
                          capture_output=True, text=True, check=False)
    return json.loads(done.stdout) if done.returncode == 0 else None


def scenes_of_gallery():
    """The settings of the gallery's scenes, by their file."""
    return {gallery.source(name, settings): settings for part in gallery.gallery.values()
            for name, settings in part.items() if settings is not gallery.a_program}


def scenes_of_lessons():
    return {str(file.relative_to(root)): [] for file in sorted((root / "docs/lessons/scenes").glob("*.toml"))}


class Laboratories(SphinxTransform):
    default_priority = 790  # before links to sources (links.py) are made of these

    def apply(self, **kwargs):
        here = pathlib.Path(self.env.doc2path(self.env.docname)).parent
        for link in list(self.document.findall(addnodes.download_reference)):
            file = (here / link["reftarget"]).resolve()
            if file.suffix != ".toml":
                continue
            path = str(file.relative_to(root))
            if self.env.docname == "docs/gallery" and link.astext() == "scene":
                self.add_run_it_here(link, path, scenes_of_gallery()[path])
            elif said := described.fullmatch(link.astext()):
                self.embed(link, path, said)

    def address(self, path, settings, second=None):
        page = self.app.builder.get_relative_uri(self.env.docname, "laboratory/index")
        return page + fragment((root / path).read_text(), settings, second)

    def add_run_it_here(self, link, path, settings):
        if path not in self.env.lagroid_runs:
            return
        here = nodes.reference("", "run it here", refuri=self.address(path, settings), internal=True, classes=["laboratory"])
        link.parent.insert(link.parent.index(link) + 1, [nodes.Text(", "), here])

    def embed(self, link, path, said):
        scene = link_to_source(self.app, self.env.docname, path, nodes.Text("the scene"))
        caption = nodes.paragraph("", "", nodes.Text(f"{link.astext()}: "), scene)
        frames = []
        if path in self.env.lagroid_runs:
            address = self.address(path, [], said["second"])
            alone = nodes.reference("", "in a window of its own", refuri=address, internal=True, classes=["laboratory"])
            caption += [nodes.Text(", "), alone, nodes.Text(f" (lagroid {self.env.lagroid_engine})")]
            frames = [nodes.raw("", f'<iframe class="laboratory" title="{link.astext()}" data-page="{address}"></iframe>',
                                format="html")]
        link.parent.replace_self([*frames, caption])


def prepare(app):
    scenes = {**scenes_of_gallery(), **scenes_of_lessons()}
    answer = ask_engine([((root / path).read_text(), settings) for path, settings in scenes.items()])
    if answer is None:
        logging.getLogger(__name__).info("without the laboratory: ./lagroid web builds it")
        answer = {"version": None, "refused": ["no engine"] * len(scenes)}
    app.env.lagroid_engine = answer["version"]
    app.env.lagroid_runs = {path for path, why in zip(scenes, answer["refused"], strict=True) if why is None}


def copy_page(app, error):
    if not error and app.env.lagroid_engine:
        shutil.copytree(web, pathlib.Path(app.outdir) / "laboratory", dirs_exist_ok=True)


def setup(app):
    app.connect("builder-inited", prepare)
    app.connect("build-finished", copy_page)
    app.add_js_file("laboratory.js")
    app.add_transform(Laboratories)
    return {"parallel_read_safe": False, "parallel_write_safe": True}
