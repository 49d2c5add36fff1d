"""Links of the pages to what is no page: a source file becomes one, of a folder the name alone is left."""
import pathlib

from docutils import nodes
from sphinx import addnodes
from sphinx.transforms import SphinxTransform
from sphinx.transforms.post_transforms import SphinxPostTransform

languages = {".hpp": "cpp", ".cpp": "cpp", ".toml": "toml", ".py": "python", ".txt": "cmake"}


def link_to_source(app, docname, path, *children):
    """A reference to the page of a source file, named from the root; the page is made at the end."""
    app.env.lagroid_sources.add(path)
    uri = app.builder.get_relative_uri(docname, f"source/{path}")
    return nodes.reference("", "", *children, internal=True, refuri=uri)


class Sources(SphinxTransform):
    """Where MyST would offer a source file for download, its page."""

    default_priority = 800

    def apply(self, **kwargs):
        root = pathlib.Path(self.env.srcdir)
        for link in list(self.document.findall(addnodes.download_reference)):
            file = (pathlib.Path(self.env.doc2path(self.env.docname)).parent / link["reftarget"]).resolve()
            if file.suffix in languages:
                path = str(file.relative_to(root))
                link.replace_self(link_to_source(self.app, self.env.docname, path, *link.children))


class Folders(SphinxPostTransform):
    default_priority = 5  # before MyST looks for a page of that name

    def run(self, **kwargs):
        here = pathlib.Path(self.env.doc2path(self.env.docname)).parent
        for link in list(self.document.findall(addnodes.pending_xref)):
            if link["reftype"] == "myst" and (here / link["reftarget"]).is_dir():
                link.replace_self(link.children)


def source_pages(app):
    for path in sorted(app.env.lagroid_sources):
        file = pathlib.Path(app.env.srcdir) / path
        code = app.builder.highlighter.highlight_block(file.read_text(), languages[file.suffix], linenos=True)
        yield f"source/{path}", {"title": path, "body": f"<h1>{path}</h1>{code}"}, "page.html"


def share_contents(app, page, template, context, tree):
    """Pages of sources are in no table of contents; the one beside them, which takes Sphinx longest, is the same for all that
    lie as deep."""
    if not page.startswith("source/"):
        return
    make, kept = context["toctree"], app.env.lagroid_contents

    def contents(**options):
        which = page.count("/"), tuple(sorted(options.items()))
        if which not in kept:
            kept[which] = make(**options)
        return kept[which]

    context["toctree"] = contents


def prepare(app):
    app.env.lagroid_sources = set()
    app.env.lagroid_contents = {}


def setup(app):
    app.connect("builder-inited", prepare)
    app.connect("html-collect-pages", source_pages)
    app.connect("html-page-context", share_contents)
    app.add_transform(Sources)
    app.add_post_transform(Folders)
    return {"parallel_read_safe": False, "parallel_write_safe": True}
