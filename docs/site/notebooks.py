"""Notebooks as pages: cells of prose are the Markdown of all pages, those of code are followed by what they left.

Notebooks are kept without outputs. Where the tests ran one in build/release, with the cells that it has now, the page
shows what came out there."""
import json
import pathlib

from myst_parser.parsers.sphinx_ import MystParser

executed = pathlib.Path(__file__).parents[2] / "build/release/python/notebooks"


def cells_of(text):
    return [{**cell, "source": "".join(cell["source"])} for cell in json.loads(text)["cells"]]


def with_outputs(name, cells):
    """The cells with the outputs of the last run, or as they are, where there was none of these very cells."""
    file = executed / name
    ran = cells_of(file.read_text()) if file.exists() else []
    return ran if [cell["source"] for cell in ran] == [cell["source"] for cell in cells] else cells


def fenced(text, language):
    return f"~~~~{language}\n{text.rstrip()}\n~~~~"


def markdown_of_output(output):
    if output["output_type"] == "stream":
        return fenced("".join(output["text"]), "text")
    data = output["data"]
    if "image/png" in data:
        picture = "".join(data["image/png"]).replace("\n", "")
        return f'<p><img alt="What the cell draws" src="data:image/png;base64,{picture}"></p>'
    return fenced("".join(data["text/plain"]), "text")


def markdown_of(cells):
    for cell in cells:
        if cell["cell_type"] == "markdown":
            yield cell["source"]
        else:
            yield fenced(cell["source"], "python")
            for output in cell["outputs"]:
                yield markdown_of_output(output)


class NotebookParser(MystParser):
    supported = ("notebook",)

    def parse(self, inputstring, document):
        name = pathlib.Path(document["source"]).name
        super().parse("\n\n".join(markdown_of(with_outputs(name, cells_of(inputstring)))), document)


def setup(app):
    app.add_source_suffix(".ipynb", "notebook")
    app.add_source_parser(NotebookParser)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
