"""Write a document as one HTML page that needs no other file and loads none: `write`.

The folder `templates/frames/html/` contains its styles and scripts. This module combines them, and lists the permitted
styles and scripts by their hashes, so that nothing else runs on the page.
"""

from __future__ import annotations

import base64
import hashlib
import json
import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from reportgen import document as tree
from reportgen.base.errors import TypesetterError
from reportgen.base.languages import setting_of
from reportgen.base.records import Record
from reportgen.base.template_folders import templates
from reportgen.document import layout
from reportgen.document.alt_text import figure_text
from reportgen.document.named_figures import figure_name, safe
from reportgen.drawing import Scene
from reportgen.formula import Expression, VectorEquation
from reportgen.formula.formula_layout import NARROW, written
from reportgen.page.svg_elements import MathmlFormulas, Painter, Pens, escape

if TYPE_CHECKING:
    from jinja2 import Environment, Template


STYLES, SCRIPTS = ("page.css",), ("page.js", "save.js")
"""Style sheets and scripts that every page has."""
FEED, GIVES, EXTENDED = "feed.js", "  return { root, own,", "const extended = new Map();"
"""Script that a form needs of each panel, its place in the panel's script, and the line by which panels get it."""
LOOKS = ("looks.js",)
"""Script of a page whose rules of style change."""
MOVING_STYLES, MOVING_SCRIPTS = ("moving.css",), ("labels.js", "moving.js")
"""Styles and scripts for panels."""


class WrittenReport(Record):
    """The report as elements, with the style sheet's rules for its pens and papers."""

    body: str
    rules: str


class Panel(Record):
    """Animated panel of a page: its title, its elements, their rules, the samples as JSON.

    Its ids begin with its `own` name, "" for the machine's.
    """

    own: str
    title: str
    body: str
    rules: str
    data: str


class Live(Record):
    """Data of a page that is renewed while it is read: its words (`live` in `words.yaml`), its revisions."""

    words: Mapping[str, str]
    moving: int
    report: int
    scripts: Sequence[str] = ("live.js",)
    styles: Sequence[str] = ("live.css",)
    form: str = ""
    """The elements of a form beside the animation; the page contains them unchanged."""
    rules: str = ""
    """Further rules of the style sheet, for what the form shows."""


def report(document: tree.Document) -> WrittenReport:
    """Return the elements of a document; raise `TypesetterError` for a formula that cannot be set."""
    pens = Pens()
    blocks = Blocks(document, pens)
    body = blocks.write(document.blocks)
    papers = (
        f"@page {name}{{size:{width:g}mm {height:g}mm;margin:12mm}}.{name}{{page:{name}}}"
        for name, (width, height) in blocks.papers.items()
    )
    return WrittenReport(body, "\n".join((pens.rules(), running(document), *papers)))


def running(document: tree.Document) -> str:
    """Return the rules for text above and below that of printed sheets, as in the PDF."""
    left, right = document.header
    below, word = document.footer
    texts = {
        "top-left": quoted(left),
        "top-right": quoted(right),
        "bottom-left": quoted(below),
        "bottom-center": f"{quoted(word)} ' ' counter(page)",
    }
    return f"@page{{{''.join(f'@{place}{{content:{text}}}' for place, text in texts.items())}}}"


def quoted(text: str) -> str:
    """Return a text as a string of a style sheet that no character of it can end."""
    return "'" + "".join(one if one.isalnum() else f"\\{ord(one):x} " for one in text) + "'"


def write(
    document: tree.Document,
    words: Mapping[str, Any],
    panels: Sequence[Panel] = (),
    live: Live | None = None,
    written: WrittenReport | None = None,
) -> str:
    """Return the whole page; `words` are those of its buttons (`page` in `words.yaml`).

    Raise `TypesetterError` if a file of the frame is missing.
    """
    written = written or report(document)
    moving_styles, moving_scripts = (MOVING_STYLES, MOVING_SCRIPTS) if panels else ((), ())
    styles = [read(name) for name in (*STYLES, *moving_styles, *(live.styles if live else ()))]
    if fonts := setting_of(document.language).typst.fonts:
        styles.insert(1, f":root{{--serif:{','.join(map(quoted, fonts))},serif;text-autospace:normal}}")
    rules = {"moving": rules_of(panels), "report": written.rules}
    # Rules that change while the page is read are the script's to put in.
    styles += [live.rules] if live else rules.values()
    scripts = [read(name) for name in (*SCRIPTS, *(LOOKS if live else ()), *moving_scripts)]
    if live and live.form:
        scripts = [EXTENDED, *(script.replace(GIVES, f"{minified(FEED)}{GIVES}") for script in scripts)]
    scripts += [minified(name) if live.form else read(name) for name in live.scripts] if live else []
    style, script = "\n".join(styles), "\n".join(scripts)
    policy = [
        "default-src 'none'",
        f"script-src {_hash(script)}",
        f"style-src {_hash(style)}",
        "img-src data: 'self'" if live and live.form else "img-src data:",
        *(["connect-src 'self'"] if live else []),
        "base-uri 'none'",
        "form-action 'none'",
    ]
    return template("page.html.j2").render(
        language=document.language,
        title=document.title,
        author=document.author,
        policy="; ".join(policy),
        style=style,
        script=script,
        words=words,
        panels=panels,
        live=live,
        editions=data(
            {"moving": live.moving, "report": live.report, "rules": rules, "words": live.words} if live else {}
        ),
        body=written.body,
    )


def rules_of(panels: Sequence[Panel]) -> str:
    """Return the style sheet's rules of all panels."""
    return "\n".join(panel.rules for panel in panels)


def template(name: str) -> Template:
    """Return a template of the frame; raise `TypesetterError` if it is missing."""
    read(name)
    return _environment().get_template(name)


@cache
def _environment() -> Environment:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    return Environment(
        loader=FileSystemLoader(templates() / "frames" / "html"),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=StrictUndefined,
    )


def read(name: str) -> str:
    """Return the text of a file of the frame, from the installed package or the checkout."""
    path = templates() / "frames" / "html" / name
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise TypesetterError(f"{path}: {error.strerror}") from error


def minified(name: str) -> str:
    """Return a script without indents and comment lines, which only readers of its source need."""
    lines = map(str.lstrip, read(name).splitlines(keepends=True))
    return "".join(line for line in lines if not line.startswith("//"))


def data(content: Mapping[str, Any]) -> str:
    """Return data as the content of a script element that no text in it can end."""
    return json.dumps(content, ensure_ascii=False, separators=(",", ":")).replace("<", "\\u003c")


def _hash(text: str) -> str:
    """Return the source expression of a security policy that allows exactly this text."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


# --- blocks of a document as elements of a page ---------------------------------------------------
# Sections, texts, formulas, tables, figures and what leads to them.

CONTENTS_LEVEL = 3
"""Deepest level of heading in the contents."""
BREAK = "<wbr>"
"""Element between two pieces of a formula, where a line may end."""
CLOSING = re.compile(r"[.,;:!?)\]”]+")
"""Punctuation that must not begin a line."""
ALIGNS = {"left": "l", "center": "c", "right": "r"}
"""The classes of cells."""


class Blocks:
    """Writer of the blocks of one document; its drawings use the page's pens."""

    def __init__(self, document: tree.Document, pens: Pens) -> None:
        self.language, self.words = document.language, document.words
        self.setting = setting_of(document.language)
        self.formulas = MathmlFormulas(document.language)
        self.painter = Painter(document.language, pens)
        self.papers: dict[str, tuple[float, float]] = {}
        """Paper sizes (mm) of plates by the names that the style sheet has for them."""
        self.below = int(any(isinstance(block, tree.Cover) for block in document.blocks))
        """Level shift: the title of a cover is above all parts."""
        sections = [block for block in document.blocks if isinstance(block, tree.Section)]
        self.sections = [section for section in sections if section.level <= CONTENTS_LEVEL]
        self._places = {id(section): f"s-{index}" for index, section in enumerate(sections)}

    def write(self, blocks: Sequence[tree.Block], room: float = tree.TEXT_WIDTH) -> str:
        """Return the elements of blocks, in order, in a room (mm); a run-in heading begins the paragraph after it."""
        lines: list[str] = []
        run_in = ""
        for block, following in pairwise((*blocks, None)):
            match block:
                case None:
                    pass
                case tree.Section(level=level) if level > CONTENTS_LEVEL:
                    run_in = self.run_in(block)
                    if not isinstance(following, tree.Paragraph):
                        lines.append(f"<p>{run_in.rstrip()}</p>")
                        run_in = ""
                case tree.Paragraph(inlines, align):
                    lines.append(f"<p{_class(align)}>{run_in}{self.inlines(inlines)}</p>")
                    run_in = ""
                case _:
                    lines.append(self.block(block, room))
        return "\n".join(filter(None, lines))

    def block(self, block: tree.Block, room: float) -> str:
        """Return the elements of a block in a room (mm)."""
        match block:
            case tree.Section(level, title, _, _, number):
                name = f"h{level + self.below}"
                return f'<{name} id="{self.place(block)}">{self.titled(number, title)}</{name}>'
            case tree.List():
                return self.items(block, room)
            case tree.Equation():
                return self.equation(block, room)
            case tree.Table():
                return self.table(block)
            case tree.Figure(scenes):
                rows = "".join(self.scene(scene, block) for scene in scenes)
                return self.figure(block, f'<div class="scenes">{rows}</div>')
            case tree.Plate(scene, paper):
                name = f"paper-{paper[0]:g}x{paper[1]:g}".replace(".", "_")
                self.papers[name] = paper
                return self.figure(block, f'<div class="scenes">{self.scene(scene, block)}</div>', f"plate {name}")
            case tree.Cover():
                return self.cover(block)
            case tree.Contents(title):
                return self.contents(title)
            case tree.Listing(lines):
                return f'<pre class="listing">{escape(chr(10).join(lines))}</pre>'
            case tree.BlankLine(label):
                return f'<p class="blank">{escape(label)}</p>'
            case _:
                return ""

    def place(self, section: tree.Section) -> str:
        """Return the anchor of a section."""
        return anchor(section.key) if section.key else self._places[id(section)]

    def titled(self, number: str, title: tree.Inlines) -> str:
        number_text = f'<span class="n">{escape(number)}</span> ' if number else ""
        return number_text + self.inlines(title)

    def run_in(self, section: tree.Section) -> str:
        return f'<strong id="{self.place(section)}">{self.titled(section.number, section.title)}</strong> '

    def contents(self, title: str) -> str:
        """Return a table of contents that can be folded, with sections nested in their parts."""
        lines = []
        depth = 0
        for section in self.sections:
            while depth > section.level:
                lines.append("</li></ol>")
                depth -= 1
            if depth == section.level:
                lines.append("</li>")
            while depth < section.level:
                lines.append("<ol>" if depth == section.level - 1 else "<ol><li>")
                depth += 1
            heading = self.titled(section.number, section.title)
            lines.append(f'<li><a href="#{self.place(section)}">{heading}</a>')
        lines.append("</li></ol>" * depth)
        heading = escape(title)
        return (
            f'<nav class="contents" id="contents" aria-label="{heading}"><details open><summary>{heading}</summary>'
            f"{''.join(lines)}</details></nav>"
        )

    def cover(self, cover: tree.Cover) -> str:
        lines = [f'<p class="institution">{escape(line)}</p>' for line in cover.institution]
        lines.append(f"<h1>{'<br>'.join(map(escape, cover.title))}</h1>")
        lines += [f'<p class="subtitle">{escape(line)}</p>' for line in cover.subtitle]
        colon = self.setting.colon.strip()
        fields = (
            f"<div><dt>{escape(label)}{colon}</dt><dd>{escape(value) if value else _DOTS}</dd></div>"
            for label, value in cover.fields
        )
        lines += [f"<dl>{''.join(fields)}</dl>", f'<p class="place">{escape(cover.place_and_date)}</p>']
        return f'<header class="cover">{"".join(lines)}</header>'

    # --- inlines ----------------------------------------------------------------------------------

    def inlines(self, inlines: tree.Inlines) -> str:
        """Return inlines in a row; a mark stays with its formula, where a browser would separate them."""
        texts: list[str] = []
        behind_formula = False
        for inline in inlines:
            text = inline.text if isinstance(inline, tree.Text) else ""
            if behind_formula and (marks := CLOSING.match(text)):
                pieces, stroke, last = texts.pop().rpartition(BREAK)
                texts.append(f'{pieces}{stroke}<span class="nb">{last}{escape(marks[0])}</span>')
                inline = tree.Text(text[marks.end() :])
            behind_formula = isinstance(inline, tree.InlineMath)
            if behind_formula and texts and texts[-1].endswith("("):
                first, stroke, pieces = self.inline(inline).partition(BREAK)
                texts[-1] = texts[-1].removesuffix("(")
                texts.append(f'<span class="nb">({first}</span>{stroke}{pieces}')
            else:
                texts.append(self.inline(inline))
        return "".join(texts)

    def inline(self, inline: tree.Inline) -> str:
        match inline:
            case tree.Text(text):
                parts = layout.UNIT.split(text)
                return "".join(
                    f'<span class="nb">{escape(part)}</span>' if index % 2 else escape(part)
                    for index, part in enumerate(parts)
                )
            case tree.Emph(of):
                return f"<em>{self.inlines(of)}</em>"
            case tree.Strong(of):
                return f"<strong>{self.inlines(of)}</strong>"
            case tree.InlineMath(expression, True):
                return self.formulas.content(expression, slashed=True)
            case tree.InlineMath(expression):
                return BREAK.join(map(self.formulas.inline, self.formulas.broken(expression)))
            case tree.Value(number):
                return f'<span class="nb">{escape(written(number, self.language).text(NARROW))}</span>'
            case tree.Reference(key, text):
                return f'<a href="#{anchor(key)}">{escape(text)}</a>'
            case tree.LineBreak():
                return "<br>"
            case tree.Blank():
                return tree.DOTS

    # --- formulas, lists and tables -----------------------------------------------------------------

    def items(self, block: tree.List, room: float) -> str:
        """Return the items of a list in a room (mm)."""
        name = "ol" if block.ordered else "ul"
        start = f' start="{block.start}"' if block.ordered and block.start != 1 else ""
        lines = "".join(f"<li>{self.write(item, room)}</li>" for item in block.items)
        return f"<{name}{start}>{lines}</{name}>"

    def equation(self, equation: tree.Equation, room: float) -> str:
        """Return an equation in a room (mm): rows of the same layout in one block, the number beside the last row."""
        groups = "".join(map(self.group, layout.in_groups(equation.rows, room)))
        number = f'<span class="number">({escape(equation.number)})</span>' if equation.number else ""
        return f'<div class="equation"{_id(equation.key)}><div class="rows">{groups}</div>{number}</div>'

    def group(self, rows: Sequence[Expression]) -> str:
        first = rows[0]
        if isinstance(first, VectorEquation):
            return self.vector_equation(first)
        lines = []
        for equated in rows:
            left, rest = self.formulas.row(equated)
            pieces = BREAK.join(map(self.formulas.displayed, rest))
            lead = f'<span class="left">{self.formulas.displayed(left)}</span> ' if left else ""
            wide = "" if left else ' class="whole"'
            lines.append(f"<div{wide}>{lead}<span>{pieces}</span></div>")
        return f'<div class="aligned">{"".join(lines)}</div>'

    def vector_equation(self, equation: VectorEquation) -> str:
        """Return the terms side by side, each with its known data below it."""
        columns = self.formulas.columns(equation)
        terms = "".join(f"<td>{self.formulas.displayed(term)}</td>" for term, _ in columns)
        lines = [f"<tr><td></td>{terms}</tr>"]
        for index, name in enumerate(equation.rows):
            entries = "".join(f"<td>{known[index]}</td>" for _, known in columns)
            lines.append(f'<tr><th scope="row">{escape(name)}</th>{entries}</tr>')
        return f'<div class="scroll"><table class="vector">{"".join(lines)}</table></div>'

    def table(self, table: tree.Table) -> str:
        caption = self.caption(self.words.table, table)
        caption_text = f"<caption><span>{caption}</span></caption>" if caption else ""
        aligns = [ALIGNS[column.align] for column in table.columns]
        head = "".join(f"<tr>{''.join(self.cells(row, aligns, 'th'))}</tr>" for row in table.head)
        rows = "\n".join(f"<tr>{''.join(self.cells(row, aligns, 'td'))}</tr>" for row in table.rows)
        look = "ruled framed" if table.framed else "ruled"
        body = f"{f'<thead>{head}</thead>' if head else ''}<tbody>{rows}</tbody>"
        return f'<div class="scroll tabled"{_id(table.key)}><table class="{look}">{caption_text}{body}</table></div>'

    def cells(self, row: Sequence[tree.Cell], aligns: Sequence[str], name: str) -> Iterator[str]:
        column = 0
        for cell in row:
            span = f' colspan="{cell.span}"' if cell.span > 1 else ""
            side = "c" if cell.span > 1 or name == "th" else aligns[column]
            # A head without words is the head of nothing.
            if name == "th" and cell.inlines:
                scope = "colgroup" if cell.span > 1 else "col"
                yield f'<th class="{side}"{span} scope="{scope}">{self.named(cell.inlines)}</th>'
            else:
                yield f'<td class="{side}"{span}>{self.inlines(cell.inlines)}</td>'
            column += cell.span

    def named(self, inlines: tree.Inlines) -> str:
        """Return inlines; those that are a single formula also get its text as a name, which a cell needs."""
        text = self.inlines(inlines)
        if any(not isinstance(inline, tree.InlineMath) for inline in inlines):
            return text
        return text.replace("<math>", f'<math aria-label="{escape(tree.plain(inlines, self.language))}">', 1)

    # --- figures ------------------------------------------------------------------------------------

    def figure(self, block: tree.Figure | tree.Plate, drawings: str, name: str = "") -> str:
        caption = self.again(block) if isinstance(block, tree.Plate) and block.continues else None
        caption = self.caption(self.words.figure, block) if caption is None else caption
        caption_text = f"<figcaption>{caption}</figcaption>" if caption else ""
        return f'<figure{_id(block.key)}{_class(name)}><div class="scroll">{drawings}</div>{caption_text}</figure>'

    def scene(self, scene: Scene, block: tree.Figure | tree.Plate) -> str:
        name = figure_text(block, scene, self.words, self.language)
        title = f"<p>{escape(scene.title)}</p>" if scene.title else ""
        file = figure_name(block)
        if isinstance(block, tree.Figure) and len(block.scenes) > 1:
            file += f"-{scene.at or block.scenes.index(scene) + 1}"
        return f"<div>{self.painter.scene(scene, name)}{save_buttons(file, self.words.save)}{title}</div>"

    def caption(self, word: str, block: tree.Table | tree.Figure | tree.Plate) -> str:
        """Return label, number and text of a caption; "" for a block without one."""
        if not (block.number or block.caption):
            return ""
        return f"<b>{escape(word)} {escape(block.number)}{self.setting.stop}</b> {self.inlines(block.caption)}"

    def again(self, block: tree.Plate) -> str:
        """Return the number of a figure that continues from the plate before."""
        where = self.setting.aside(escape(self.words.continued))
        return f"<b>{escape(self.words.figure)} {escape(block.number)}</b>{where}"


def save_buttons(file: str, label: str) -> str:
    """Return buttons that save the preceding drawing to a file of this name; the style sheet has their labels."""
    buttons = "".join(
        f'<button type="button" data-save="{kind}" aria-label="{kind.upper()}"></button>' for kind in ("svg", "png")
    )
    return f'<p class="save" role="group" aria-label="{escape(label)}" data-name="{escape(safe(file))}">{buttons}</p>'


_DOTS = '<span class="dots"></span>'


def anchor(key: str) -> str:
    """Return the anchor of a block for references by its key."""
    return escape(f"k-{key}")


def _id(key: str) -> str:
    return f' id="{anchor(key)}"' if key else ""


def _class(name: str) -> str:
    return f' class="{name}"' if name else ""
