"""The Markdown pages of the project, read by the parser with which the documentation site is built."""
import dataclasses
import pathlib
import re

from markdown_it import MarkdownIt

root = pathlib.Path(__file__).resolve().parents[2]
parser = MarkdownIt("commonmark").enable("table")


@dataclasses.dataclass
class Block:
    """A block of code: its language, empty where it is only indented; its text; where it begins."""

    page: str
    line: int
    language: str
    text: str

    def __str__(self):
        return f"{self.page}:{self.line}"


@dataclasses.dataclass
class Page:
    path: pathlib.Path
    text: str

    @property
    def name(self):
        return str(self.path.relative_to(root))

    def blocks(self):
        for token in parser.parse(self.text):
            if token.type in ("fence", "code_block"):
                language = token.info.strip() if token.type == "fence" else ""
                if not language.startswith("{"):  # a directive of the site, such as a table of contents
                    yield Block(self.name, token.map[0] + 1, language, token.content)

    def inlines(self):
        """The inline tokens, links and code among them, with the line on which their paragraph begins."""
        for token in parser.parse(self.text):
            if token.type == "inline":
                for child in token.children:
                    yield token.map[0] + 1, child

    def anchors(self):
        """The names of its headings, as GitHub and the site make them."""
        tokens = parser.parse(self.text)
        seen = {}
        for opening, inline in zip(tokens, tokens[1:]):
            if opening.type == "heading_open":
                title = "".join(child.content for child in inline.children if child.type in ("text", "code_inline"))
                slug = re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")
                seen[slug] = seen.get(slug, -1) + 1
                yield slug if seen[slug] == 0 else f"{slug}-{seen[slug]}"


def pages():
    """All pages, those of builds and runs apart."""
    folders = [path for path in root.iterdir() if path.is_dir() and path.name not in ("build", "out")]
    files = [*root.glob("*.md"), *(file for folder in folders for file in folder.rglob("*.md"))]
    return [Page(path, path.read_text()) for path in sorted(files)
            if not any(part.startswith(".") for part in path.relative_to(root).parts)]


def flush_left(text):
    return "\n".join(line.strip() for line in text.strip().splitlines())
