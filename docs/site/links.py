"""Links of the Markdown pages to a folder, which is no page of the site: the name alone is left."""
import pathlib

from sphinx.addnodes import pending_xref
from sphinx.transforms.post_transforms import SphinxPostTransform


class Folders(SphinxPostTransform):
    default_priority = 5  # before MyST looks for a page of that name

    def run(self, **kwargs):
        here = pathlib.Path(self.env.doc2path(self.env.docname)).parent
        for link in list(self.document.findall(pending_xref)):
            if link["reftype"] == "myst" and (here / link["reftarget"]).is_dir():
                link.replace_self(link.children)


def setup(app):
    app.add_post_transform(Folders)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
