"""The API reference: the public docstrings of a folder's headers, as Doxygen finds them, on one page.

    ```{api} core
    ```

stands for the headers of core/, each with what it says of itself and its public concepts, classes, functions and types
in the order in which they are written. On every other page `names` of them become links.
"""
import collections
import dataclasses
import os
import pathlib
import re
import shutil
import subprocess
import xml.etree.ElementTree as xml

from docutils import nodes
from sphinx import addnodes
from sphinx.transforms.post_transforms import SphinxPostTransform
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective

from links import link_to_source

log = logging.getLogger(__name__)


@dataclasses.dataclass
class Entity:
    """A concept, class, function, type, enumeration or constant: its name, its declaration in C++, what it says."""

    name: str
    declaration: str
    said: list  # docutils nodes
    line: int
    members: list = dataclasses.field(default_factory=list)


def text(element):
    return "" if element is None else re.sub(r"\s+", " ", "".join(element.itertext())).strip()


def tidy(code):
    """C++ as clang-format would space it: Doxygen writes A< B > and A &a."""
    code = re.sub(r" +", " ", code.replace("lagroid::", ""))
    code = re.sub(r"(?<=[\w>\]]) (&&|[&*])(?=[\w.])", r"\1 ", code)
    code = re.sub(r"(?<=[\w>]) ([&*]+)(?=$|[,)>]| operator)", r"\1", code)
    code = re.sub(r" ?=(default|delete|0)$", r" = \1", code)
    out, depth = "", 0
    for part in re.split(r"((?<=\w)< | >)", code):
        opens, closes = part == "< ", part == " >" and depth > 0
        depth += opens - closes
        out += "<" if opens else ">" if closes else part
    return out


def prose(element):
    """Doxygen's paragraphs as docutils nodes."""
    out = []

    def inline(node, into):
        into += nodes.Text(node.text or "")
        for child in node:
            if child.tag == "computeroutput":
                into += nodes.literal("", re.sub(r"\\([\\<>@&#])", r"\1", text(child)))
            elif child.tag in ("emphasis", "bold"):
                into += (nodes.emphasis if child.tag == "emphasis" else nodes.strong)("", text(child))
            elif child.tag == "verbatim":
                block = nodes.literal_block("", re.sub(r"^\n+|\s+$", "", child.text or ""), language="text")
                parts.extend([block, nodes.paragraph()])
                into = parts[-1]
            elif child.tag in ("itemizedlist", "orderedlist"):
                items = (nodes.bullet_list if child.tag == "itemizedlist" else nodes.enumerated_list)()
                items += [nodes.list_item("", *prose(item)) for item in child]
                parts.extend([items, nodes.paragraph()])
                into = parts[-1]
            elif child.tag in ("ref", "ulink"):
                into += nodes.Text(text(child))
            else:
                raise ValueError(f"docs/site/api.py knows no <{child.tag}> of Doxygen's")
            into += nodes.Text(child.tail or "")

    for paragraph in element.findall("para"):
        parts = [nodes.paragraph()]
        inline(paragraph, parts[0])
        out += [part for part in parts if not isinstance(part, nodes.paragraph) or part.astext().strip()]
    return out


def said_by(element):
    return prose(element.find("briefdescription")) + prose(element.find("detaileddescription"))


def template_of(element):
    parameters = element.find("templateparamlist")
    if parameters is None:
        return ""
    out = []
    for parameter in parameters:
        words = [text(parameter.find("type")), text(parameter.find("declname"))]
        default = text(parameter.find("defval"))
        out.append(" ".join(filter(None, words)) + (f" = {default}" if default else ""))
    clause = text(element.find("requiresclause"))
    return f"template <{', '.join(out)}> {'requires ' + clause.removeprefix('requires ') + ' ' if clause else ''}"


def declaration_of(member):
    kind = member.get("kind")
    name = member.findtext("name")
    if kind == "enum":
        values = ", ".join(value.findtext("name") for value in member.findall("enumvalue"))
        return f"enum {'class ' if member.get('strong') == 'yes' else ''}{name} {{ {values} }}"
    type_ = text(member.find("type"))
    if kind == "typedef":
        return f"{template_of(member)}using {name} = {type_}"
    initial = text(member.find("initializer")) if kind == "variable" else ""
    signature = text(member.find("argsstring"))
    static = "static " if member.get("static") == "yes" and not type_.startswith("static") else ""
    return f"{template_of(member)}{static}{type_} {name}{signature}{' ' + initial if initial else ''}".strip()


def entity_of_member(member):
    said = said_by(member)
    if member.get("kind") == "enum":
        items = [nodes.definition_list_item("", nodes.term("", "", nodes.literal("", value.findtext("name"))),
                                            nodes.definition("", *said_by(value)))
                 for value in member.findall("enumvalue") if said_by(value)]
        if items:
            said.append(nodes.definition_list("", *items))
    return Entity(member.findtext("name"), tidy(declaration_of(member)), said, int(member.find("location").get("line")))


def public_members(compound):
    for section in compound.findall("sectiondef"):
        for member in section.findall("memberdef"):
            if member.get("prot") == "public" and member.get("kind") in ("function", "variable", "typedef", "enum"):
                yield member


def entity_of_compound(compound):
    """A class, or a concept."""
    name = compound.findtext("compoundname").removeprefix("lagroid::")
    location = compound.find("location")
    if compound.get("kind") == "concept":
        written = "".join(compound.find("initializer").itertext()).strip()
        written = written.replace("template<", "template <", 1).replace("lagroid::", "").replace(" =  ", " = ", 1)
        return Entity(name, written, said_by(compound), int(location.get("line")))
    bases = ", ".join(tidy(text(base)) for base in compound.findall("basecompoundref") if base.get("prot") == "public")
    head = f"{template_of(compound)}{compound.get('kind')} {name}{' : ' + bases if bases else ''}"
    members = sorted((entity_of_member(member) for member in public_members(compound)), key=lambda it: it.line)
    return Entity(name, tidy(head), said_by(compound), int(location.get("line")), members)


def read_api(folder):
    """Header -> what it says of itself, and what it declares, by Doxygen's XML."""
    about, entities = {}, collections.defaultdict(list)
    for path in sorted(folder.glob("*.xml")):
        compound = xml.parse(path).getroot().find("compounddef")
        if compound is None:
            continue
        kind, location = compound.get("kind"), compound.find("location")
        if kind == "file":
            about[location.get("file")] = said_by(compound)
        elif kind in ("class", "struct", "concept"):
            if compound.get("prot", "public") == "public":
                entities[location.get("file")].append(entity_of_compound(compound))
        elif kind == "namespace":
            for member in public_members(compound):
                entities[member.find("location").get("file")].append(entity_of_member(member))
    for declared in entities.values():
        declared.sort(key=lambda entity: entity.line)
    return about, entities


def run_doxygen(app):
    root = pathlib.Path(app.srcdir)
    out = pathlib.Path(app.doctreedir).parent / "api"
    shutil.rmtree(out, ignore_errors=True)  # what is there may be of headers that moved
    out.mkdir(parents=True)
    done = subprocess.run(["doxygen", "docs/site/Doxyfile"], cwd=root, env={**os.environ, "LAGROID_API": str(out)},
                          capture_output=True, text=True)
    for line in done.stderr.splitlines():
        log.warning("Doxygen: %s", line)
    if done.returncode != 0:
        raise RuntimeError("doxygen failed")
    app.env.lagroid_api = read_api(out / "xml")


def anchor(name):
    return "api-" + nodes.make_id(re.sub(r"<.*", "", name))


class Api(SphinxDirective):
    """The headers of one folder."""

    required_arguments = 1

    def run(self):
        about, entities = self.env.lagroid_api
        folder = self.arguments[0]
        headers = sorted(header for header in about if os.path.dirname(header) == folder)
        if not headers:
            raise self.error(f'no headers in "{folder}"')
        self.ids = set()
        return [node for header in headers for node in self.header(header, about[header], entities[header])]

    def header(self, header, about, entities):
        shown = [entity for entity in entities if entity.said or any(member.said for member in entity.members)]
        if not about:
            log.warning("%s: the header does not say what it is", header)
        section = nodes.section(ids=[nodes.make_id(header)])
        section += nodes.title("", os.path.basename(header))
        included = nodes.literal("", f"#include <lagroid/{header}>")
        source = link_to_source(self.env.app, self.env.docname, header, included)
        section += nodes.paragraph("", "", source)
        section += [node.deepcopy() for node in about]
        for entity in shown:
            section += self.entity(entity)
        return [section]

    def code(self, declaration):
        return nodes.literal_block("", declaration, language="cpp")

    def entity(self, entity):
        block = nodes.container(classes=["api-entity"])
        target = anchor(entity.name)
        index = addnodes.index(entries=[("single", entity.name, target, "", None)])
        block += index
        if target not in self.ids:
            self.ids.add(target)
            block["ids"].append(target)
            short = re.sub(r"^(?:[a-z_]+::)+|<.*", "", entity.name)  # without namespaces and arguments
            self.env.lagroid_names.setdefault(short, (self.env.docname, target))
        block += self.code(entity.declaration)
        block += [node.deepcopy() for node in entity.said]
        fields = [member.declaration + ";" for member in entity.members if not member.said]
        told = [member for member in entity.members if member.said]
        body = nodes.container(classes=["api-members"])
        for member in told:
            self.env.lagroid_members[member.name].add((self.env.docname, target))
            body += addnodes.index(entries=[("single", f"{member.name} ({entity.name})", target, "", None)])
            body += self.code(member.declaration)
            body += [node.deepcopy() for node in member.said]
        if fields:
            body += self.code("\n".join(fields))
        if body.children:
            block += body
        return block


class LinkNames(SphinxPostTransform):
    """`Groupoid` on any page leads to where the reference says what it is."""

    default_priority = 900

    def place(self, name):
        """Where an entity is described, or the only class that has a member of that name. Plain words, such as
        `constant`, mean other things on the pages too."""
        if not re.search(r"_|[A-Z]", name):
            return None
        classes = self.env.lagroid_members.get(name, ())
        return self.env.lagroid_names.get(name) or (next(iter(classes)) if len(classes) == 1 else None)

    def run(self, **kwargs):
        for literal in list(self.document.findall(nodes.literal)):
            found = self.place(literal.astext())
            if found is None or isinstance(literal.parent, nodes.reference):
                continue
            docname, target = found
            if docname == self.env.docname:
                link = nodes.reference("", "", internal=True, refid=target)
            else:
                uri = self.app.builder.get_relative_uri(self.env.docname, docname)
                link = nodes.reference("", "", internal=True, refuri=f"{uri}#{target}")
            literal.replace_self(link)
            link += literal


def prepare(app):
    app.env.lagroid_names = {}
    app.env.lagroid_members = collections.defaultdict(set)
    run_doxygen(app)


def setup(app):
    app.connect("builder-inited", prepare)
    app.add_directive("api", Api)
    app.add_post_transform(LinkNames)
    return {"parallel_read_safe": False, "parallel_write_safe": True}
