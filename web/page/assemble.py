"""Makes the site and the one file of what was compiled and bundled: assemble.py BUILT SITE SCENE..."""
import base64
import hashlib
import json
import pathlib
import shutil
import sys


def in_script(data):
    """JSON that may stand in a page."""
    return json.dumps(data).replace("<", "\\u003c")


def page_with(places):
    page = (here / "page.html").read_text()
    for name, text in places.items():
        head, tail = page.split(f"@{name}@")
        page = head + text + tail
    return page


here = pathlib.Path(__file__).resolve().parent
built, site, *scenes = map(pathlib.Path, sys.argv[1:])
# The pendulum first: it is what a page begins with.
gallery = {path.stem: path.read_text() for path in sorted(scenes, key=lambda path: (path.stem != "pendulum", path.stem))}
gallery["your own Lagrangian"] = (here / "own_lagrangian.toml").read_text()
style = (here / "page.css").read_text()
program = (built / "page.js").read_text()
worker = (built / "lagroid_web.js").read_text() + "\n" + (built / "worker.js").read_text()
wasm = (built / "lagroid_web.wasm").read_bytes()
scenes_in_page = f'<script type="application/json" id="gallery">{in_script(gallery)}</script>'

site.mkdir(parents=True, exist_ok=True)
(site / "page.css").write_text(style)
(site / "page.js").write_text(program)
(site / "worker.js").write_text(worker)
shutil.copyfile(built / "lagroid_web.wasm", site / "lagroid.wasm")
(site / "index.html").write_text(page_with({
    "POLICY": "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; worker-src 'self'; "
              "connect-src 'self'; img-src data: blob:",
    "STYLE": '<link rel="stylesheet" href="page.css">',
    "SCRIPTS": f'{scenes_in_page}\n<script src="page.js"></script>',
}))

# In one file nothing may be asked for at all, and no script runs but this one.
digest = base64.b64encode(hashlib.sha256(program.encode()).digest()).decode()
(site / "lagroid.html").write_text(page_with({
    "POLICY": f"default-src 'none'; script-src 'sha256-{digest}' 'wasm-unsafe-eval'; style-src 'unsafe-inline'; "
              "worker-src blob:; img-src data: blob:",
    "STYLE": f"<style>{style}</style>",
    "SCRIPTS": "\n".join([
        scenes_in_page,
        f'<script type="application/json" id="worker">{in_script(worker)}</script>',
        f'<script type="application/octet-stream" id="wasm">{base64.b64encode(wasm).decode()}</script>',
        f"<script>{program}</script>",
    ]),
}))
