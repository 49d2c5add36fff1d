"""Formulas as MathML, by docutils: no script, no network, the same from a file as from a server."""
from docutils import nodes
from docutils.utils.math.latex2mathml import tex2mathml


def formula(inline):
    def visit(self, node):
        source = node.astext()
        try:
            written = tex2mathml(source.replace(r"\dots", r"\ldots"), inline=inline)  # one name of two is known there
        except SyntaxError as error:
            raise ValueError(f"{self.builder.current_docname}: no formula: {source}: {error}") from error
        self.body.append(written if inline else f'<div class="math">{written}</div>')
        raise nodes.SkipNode

    return visit


def setup(app):
    app.add_html_math_renderer("mathml", (formula(True), None), (formula(False), None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
