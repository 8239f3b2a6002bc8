"""Write a document as LaTeX source: words and numbers come from the tree, the layout from the frame.

The body consists of PyLaTeX fragments and short macros that the Jinja2 frame `templates/frames/latex` defines.
Contents, links and outline use pdfTeX's own primitives: the titles are known here, so that only page numbers require a
second pass.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from itertools import islice, pairwise
from typing import TYPE_CHECKING

from reportgen import document as tree
from reportgen.base.languages import setting_of
from reportgen.base.records import Record
from reportgen.base.template_folders import templates
from reportgen.base.units import Language
from reportgen.document import layout
from reportgen.drawing import Scene
from reportgen.formula import Expression, Symbol, VectorEquation
from reportgen.formula.formula_layout import columns
from reportgen.writers.latex_math import LatexFormulas, declarations, escape, hexadecimal
from reportgen.writers.scene_source import paint_latex

if TYPE_CHECKING:
    from jinja2 import Template

CONTENTS_LEVEL = 3
"""Deepest level of heading in the contents and the outline."""
HEADING, OPENING, TITLE, ROW = 12, 20, 14, 5.0
"""Approximate heights (mm) of a heading, of the words before a table, of its caption, and of a row."""
WORDS, LINE = 9, 12
"""Approximate heights (mm) of the words before an equation that leads to a table, and of a line of it."""
FRAME = r"\vrule width\heavyrulewidth"
"""Side rule of a framed table."""
LEADING = 1.2
"""Distance of lines, in font sizes."""
STOREYS, LONG, SHORT = 42, 28, 18
"""Heights (mm) of words with a vector equation in two storeys, with one in one or a list's start, or with others."""
ONE_STOREY = 6
"""Largest number of vectors in one storey."""
CHARACTERS, TEXT_LINE = 85, 5.0
"""Approximate number of characters in a line of text, and its height (mm)."""


FAMILIES: Mapping[str, tuple[str, str, str]] = dict.fromkeys(
    ("Times New Roman", "Times", "TeX Gyre Termes", "Nimbus Roman", "Liberation Serif"), ("tgtermes.sty", "qtm", "utm")
)
"""Fonts by their names in other systems: a package with its family, and the family that VnTeX has if it is missing."""


def write(document: tree.Document, letter: layout.Letter = layout.OWN_LETTER) -> str:
    """Return the complete LaTeX source, ready to compile.

    Raises `TypesetterError` for a character that the fonts do not have.
    """
    return "".join(pieces(document, letter))


def pieces(document: tree.Document, letter: layout.Letter = layout.OWN_LETTER) -> Iterator[str]:
    """Yield the source as it is written: everything up to the end of the contents, then each block.

    Raises `TypesetterError` for a character that the fonts do not have.
    """
    frame = _frame().render(
        title=hexadecimal(document.title),
        author=hexadecimal(document.author),
        language=document.language,
        header=[escape(text) for text in document.header],
        footer=[escape(text) for text in document.footer],
        characters=declarations(),
        gap=f"{layout.ABREAST:g}",
        close=document.close,
        **_type(letter, document.language),
    )
    identity = hashlib.sha256()
    body = _Writer(document).each(document.blocks)
    listed = next((n for n, block in enumerate(document.blocks, 1) if isinstance(block, tree.Contents)), 0)
    begun = "\n".join((frame, *islice(body, listed), ""))
    yield begun
    identity.update(begun.encode())
    for block in body:
        identity.update(block.encode())
        yield f"{block}\n"
    yield _command("closing", identity.hexdigest()[:32])


def opening(letter: layout.Letter, close: bool, language: Language) -> str:
    """Return the common beginning of the source of every document in this letter: LaTeX's own files."""
    frame = _frame()
    return "".join(frame.blocks["opening"](frame.new_context({"close": close, **_type(letter, language)})))


def _type(letter: layout.Letter, language: Language) -> Mapping[str, object]:
    """Return the frame's variables for the letter and the language."""
    return {
        "setting": setting_of(language),
        "family": FAMILIES.get(letter.font),
        "size": f"{letter.size:g}",
        "lead": f"{letter.size * LEADING:.4g}",
        "larger": letter.size != layout.TEXT_SIZE,
    }


@cache
def _frame() -> Template:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(
        loader=FileSystemLoader(templates() / "frames" / "latex"),
        block_start_string="<%",
        block_end_string="%>",
        variable_start_string="<(",
        variable_end_string=")>",
        comment_start_string="<#",
        comment_end_string="#>",
        trim_blocks=True,
        undefined=StrictUndefined,
        autoescape=False,
    )
    return environment.get_template("report.tex.j2")


def _command(name: str, *arguments: str) -> str:
    return f"\\{name}{''.join(f'{{{argument}}}' for argument in arguments)}"


class _Writer:
    """Writer of the blocks of one document as LaTeX, with the targets of links and contents."""

    def __init__(self, document: tree.Document) -> None:
        self.document = document
        self.language = document.language
        self.formulas = LatexFormulas(document.language)
        self.entries = {id(entry.section): entry for entry in _entries(document.blocks)}
        self.places: Mapping[str, str] = {
            **{key: f"k{index}" for index, key in enumerate(_keys(document.blocks))},
            **{entry.section.key: entry.place for entry in self.entries.values() if entry.section.key},
        }

    def blocks(self, blocks: Sequence[tree.Block]) -> str:
        return "\n".join(self.each(blocks))

    def each(self, blocks: Sequence[tree.Block]) -> Iterator[str]:
        return (self.kept(blocks[index:]) for index in range(len(blocks)))

    def kept(self, blocks: Sequence[tree.Block]) -> str:
        """Return the first of the blocks, kept on one page with the next one if it leads to that."""
        block, following = blocks[0], blocks[1] if len(blocks) > 1 else None
        if isinstance(block, tree.Section):
            room = self.room_to_table(blocks)
            return (_command("needed", f"{room:g}mm") if room else "") + self.block(block)
        if not layout.leads(block, following, self.language):
            return self.block(block)
        if isinstance(block, tree.List):
            return self.list(block, r"\keeplist")
        if isinstance(block, tree.Equation):
            return rf"\let\eqend\nobreak {self.block(block)}\let\eqend\relax\par\nobreak"
        room = self.room_to_table(blocks)
        name, room = ("needed", room) if room else ("neededbelow", self.room_to_go_on(blocks))
        return f"{_command(name, f'{room:g}mm')}{self.block(block)}\\par\\nobreak"

    def room_to_go_on(self, blocks: Sequence[tree.Block]) -> float:
        """Return the approximate height (mm) of words with the block that they lead to, and with its own successor."""
        _, following, *after = blocks
        room = _beginning(following)
        if len(after) > 1 and isinstance(after[0], tree.Paragraph) and layout.leads(following, after[0], self.language):
            lines = -(-len(tree.plain(after[0].inlines, self.language)) // CHARACTERS)
            room += (lines - 1) * TEXT_LINE + self.room_to_go_on(after)
        return room

    def room_to_table(self, blocks: Sequence[tree.Block]) -> float:
        """Return the approximate height (mm) of blocks that lead one to the next up to a table; 0 for others."""
        room = 0.0
        for block, following in pairwise(blocks):
            if isinstance(block, tree.Section):
                room += HEADING
            elif not layout.leads(block, following, self.language):
                return 0.0
            elif isinstance(block, tree.Equation):
                room += LINE * layout.lines(block.rows, layout.room_for(tree.TEXT_WIDTH, self.document.close))
            else:
                room += WORDS if isinstance(following, tree.Equation) else OPENING
            if isinstance(following, tree.Table):
                return room + _height(following)
        return 0.0

    def block(self, block: tree.Block) -> str:
        match block:
            case tree.Section():
                return self.section(block)
            case tree.Paragraph(inlines, align):
                return self.paragraph(self.inlines(inlines), align)
            case tree.List():
                return self.list(block)
            case tree.Equation():
                return self.equation(block)
            case tree.Table():
                return self.table(block)
            case tree.Figure():
                return self.figure(block)
            case tree.Plate(scene, (width, height), continues=continues):
                caption = (self.again if continues else self.caption)(self.document.words.figure, block)
                painted = paint_latex(scene, self.formulas)
                return _command("plate", f"{width:g}mm", f"{height:g}mm", painted, caption)
            case tree.Cover():
                return self.cover(block)
            case tree.Contents():
                return self.contents(block)
            case tree.BlankLine(label):
                return _command("blankline", escape(label) + r"\ " if label else "")
            case tree.Listing(lines):
                return "\n".join((r"\begingroup\scriptsize\begin{verbatim}", *lines, r"\end{verbatim}\endgroup"))
            case tree.PageBreak():
                return r"\clearpage"

    # --- inlines ----------------------------------------------------------------------------------

    def inlines(self, inlines: tree.Inlines) -> str:
        return "".join(map(self.inline, inlines))

    def inline(self, inline: tree.Inline) -> str:
        match inline:
            case tree.Text(text):
                return layout.FILE.sub(r"\\mbox{\1}", escape(text))
            case tree.Emph(of):
                return rf"\emph{{{self.inlines(of)}}}"
            case tree.Strong(of):
                return rf"\textbf{{{self.inlines(of)}}}"
            case tree.InlineMath(expression, slashed):
                return self.formulas.content(expression, slashed)
            case tree.Value(number):
                return self.formulas.content(number)
            case tree.Reference(key, text):
                place = self.places.get(key)
                return rf"\link{{{place}}}{{{escape(text)}}}" if place else escape(text)
            case tree.LineBreak():
                return r"\newline "
            case tree.Blank():
                return r"\dots\dots{}"

    def paragraph(self, source: str, align: str) -> str:
        if not align:
            return f"\n{source}\n"
        from pylatex import Center, FlushRight, NoEscape

        environment = Center if align == "center" else FlushRight
        return str(environment(data=NoEscape(source.replace(r"\newline ", r"\\[0pt] "))).dumps())

    # --- structure --------------------------------------------------------------------------------

    def section(self, section: tree.Section) -> str:
        entry = self.entries.get(id(section))
        place = entry.place if entry else self.places.get(section.key, "")
        title = self.title(section)
        marks = rf"\place{{{place}}}" if place else ""
        if entry:
            words = f"{section.number} {_plain(section.title)}".strip()
            marks += _command("outlineentry", place, str(-entry.below), hexadecimal(words))
        return _command("heading", str(section.level), marks, title)

    def title(self, section: tree.Section) -> str:
        number = rf"{escape(section.number)}\quad " if section.number else ""
        return number + self.inlines(section.title)

    def contents(self, contents: tree.Contents) -> str:
        lines = [r"\clearpage", _command("headline", escape(contents.title))]
        lines += (
            _command("contentsentry", str(entry.section.level), entry.place, self.title(entry.section))
            for entry in self.entries.values()
            if entry.section.level < CONTENTS_LEVEL or not contents.brief
        )
        return "\n".join([*lines, r"\clearpage"] if contents.alone else lines)

    def list(self, block: tree.List, end: str = "") -> str:
        from pylatex import Command, Itemize, NoEscape

        environment = Itemize()
        for number, item in enumerate(block.items, block.start):
            environment.append(Command("item", options=f"{number}." if block.ordered else None))
            # A text that begins with a bracket must not become an option of the command before it.
            environment.append(NoEscape(r"\relax " + self.blocks(item).strip()))
        if end:
            environment.append(NoEscape(end))
        return str(environment.dumps())

    def cover(self, cover: tree.Cover) -> str:
        institution = [escape(line) for line in cover.institution]
        lines = [
            _command("coverinstitution", line if index else rf"\textbf{{{line}}}")
            for index, line in enumerate(institution)
        ]
        lines += [r"\coverrule", r"\vfill"]
        lines += (_command("covertitle", escape(line)) for line in cover.title)
        lines.append(r"\vskip5mm")
        lines += (_command("coversubtitle", escape(line)) for line in cover.subtitle)
        lines.append(r"\vfill")
        fields = (
            _command("coverfield", escape(f"{label}:"), rf"\textbf{{{escape(value)}}}" if value else r"\dotline")
            for label, value in cover.fields
        )
        lines += [_command("coverfields", "%\n".join(fields)), r"\vfill"]
        lines.append(_command("coverfoot", escape(cover.place_and_date)))
        return "\n".join([r"\begin{coverpage}", *lines, r"\end{coverpage}"])

    # --- equations --------------------------------------------------------------------------------

    def equation(self, equation: tree.Equation) -> str:
        place = rf"\place{{{self.places[equation.key]}}}" if equation.key else ""
        number = place + (f"({escape(equation.number)})" if equation.number else "")
        *before, last = layout.in_groups(equation.rows, layout.room_for(tree.TEXT_WIDTH, self.document.close))
        return "\n".join([*(self.aligned(group, "") for group in before), self.aligned(last, number)])

    def aligned(self, group: Sequence[Expression], number: str) -> str:
        """Return rows that are aligned together, with the number on the last."""
        rows = []
        for index, row in enumerate(group):
            macro = "L" if index == len(group) - 1 else "R"
            left, rest = self.formulas.aligned(row)
            rows.append(rf"\{macro}{{{left}}}{{{rest}}}")
        return f"\\EQ{{{number}}}{{%\n" + "%\n".join(rows) + "}"

    # --- figures and tables -----------------------------------------------------------------------

    def caption(self, word: str, block: tree.Table | tree.Figure | tree.Plate) -> str:
        place = rf"\place{{{self.places[block.key]}}}" if block.key else ""
        if not (block.caption or block.number):
            return place
        label = f"{word} {block.number}".strip() + ("." if block.caption else "")
        return _command("captiontext", place, escape(label), self.inlines(block.caption))

    def again(self, word: str, block: tree.Table | tree.Figure | tree.Plate, part: int = 0) -> str:
        """Return the caption of a continuation from the page before, or of a later part."""
        words = self.document.words
        where = words.part.format(part=part) if part else words.continued
        return _command("captiontext", "", escape(f"{word} {block.number} ({where})"), "")

    def figure(self, figure: tree.Figure) -> str:
        """Return the rows of a figure with the caption below, on as many pages as they need."""
        if figure.turned:
            drawing = paint_latex(figure.scenes[0], self.formulas)
            rotated = _command("turned", drawing, self.caption(self.document.words.figure, figure))
            return f"\\begin{{turnedscene}}\n{rotated}\n\\end{{turnedscene}}"
        word = self.document.words.figure
        first, *others = layout.in_parts(figure)
        place = "herescenes" if figure.here else "scenes"
        further = (self.rows(rows, self.again(word, figure, part), place) for part, rows in enumerate(others, 2))
        return "\n".join((self.rows(first, self.caption(word, figure), place), *further))

    def rows(self, rows: Sequence[Sequence[Scene]], caption: str, place: str = "scenes") -> str:
        """Return rows of scenes with the caption below."""
        gap = rf"\hskip{layout.SCENE_GAP:g}mm "
        drawn = "\n\\scenegap\n".join(_command("scenerow", gap.join(map(self.scene, row))) for row in rows)
        return "\n".join([rf"\begin{{{place}}}", drawn, _command("figurecaption", caption), rf"\end{{{place}}}"])

    def scene(self, scene: Scene) -> str:
        painted = paint_latex(scene, self.formulas)
        return _command("titledscene", painted, escape(scene.title)) if scene.title else painted

    def table(self, block: tree.Table) -> str:
        """Return a long table below its caption; its head is repeated on every page."""
        from pylatex import LongTable, NoEscape

        columns = "".join(_column(column.width, column.align) for column in block.columns)
        if block.framed:
            columns = f"!{{{FRAME}}}{columns}!{{{FRAME}}}"
        environment = LongTable(NoEscape(columns), width=len(block.columns))
        head = self.head(block)
        if caption := self.caption(self.document.words.table, block):
            title = rf"\multicolumn{{{len(block.columns)}}}{{c}}{{\tablecaption{{{caption}}}}}\\*[0pt]"
            environment.append(NoEscape(title))
        environment.append(NoEscape(head + r"\endfirsthead"))
        if block.number:
            again = self.again(self.document.words.table, block)
            title = rf"\multicolumn{{{len(block.columns)}}}{{c}}{{\tablecaption{{{again}}}}}\\*[0pt]"
            head = f"{title}\n{head}"
        environment.append(NoEscape(head + r"\endhead"))
        environment.append(NoEscape(r"\bottomrule\endfoot"))
        for index, (row, stays) in enumerate(zip(block.rows, layout.stays(block), strict=True)):
            end = r"\\*[0pt]"
            # A rule between rows would leave gaps in the sides of a frame.
            if index < len(block.rows) - 1 and not block.framed:
                end += rf"\rowrule{{{len(block.columns)}}}{{{10000 if stays else 0}}}"
            environment.append(NoEscape(self.row(row, block.columns) + end))
        framed = r"\framedtable" if block.framed else ""
        room = _command("needed", f"{_height(block):g}mm")
        if len(layout.held(block)) > 1:
            room = _command("figuresbefore", f"{TITLE + ROW * (len(block.head) + len(block.rows)):g}mm") + room
        return f"{room}\\begin{{belowfigures}}\\tablesize{framed}\n{environment.dumps()}\n\\end{{belowfigures}}"

    def head(self, block: tree.Table) -> str:
        # Every option is written explicitly, because a cell's text may begin with a bracket.
        lines = [r"\toprule[\heavyrulewidth]"]
        for index, row in enumerate(block.head):
            lines.append(self.row(row, block.columns, head=True) + r"\\*[0pt]")
            if index < len(block.head) - 1:
                lines.append(_rules_below(row))
        lines.append(r"\midrule" if block.head else "")
        return "\n".join(lines) + "\n"

    def row(self, row: Sequence[tree.Cell], columns: Sequence[tree.Column], head: bool = False) -> str:
        from pylatex import MultiColumn, NoEscape

        printed, at = [], 0
        for cell in row:
            source = self.inlines(cell.inlines)
            covered = columns[at : at + cell.span]
            if cell.span > 1 or (head and covered and covered[0].align != "center"):
                align = "center" if head else covered[0].align
                width = sum(column.width for column in covered)
                spec = NoEscape(_column(width, align))
                source = MultiColumn(cell.span, align=spec, data=NoEscape(source)).dumps()
            printed.append(source)
            at += cell.span
        return " & ".join(printed)


def _beginning(block: tree.Block | None) -> float:
    """Return the approximate height (mm) of the beginning of a block with the words that lead to it."""
    match block:
        case tree.Equation(rows=(VectorEquation() as first, *_)):
            return LONG if len(list(columns(first))) <= ONE_STOREY else STOREYS
        case tree.Equation():
            return SHORT
        case _:
            return LONG


def _height(block: tree.Table) -> float:
    """Return the approximate height (mm) of a table with its caption, up to its first possible break."""
    return TITLE + ROW * (len(block.head) + layout.held(block)[0])


def _column(width: float, align: str) -> str:
    return f"{align[0].upper()}{{{width:g}mm}}"


def _rules_below(row: Sequence[tree.Cell]) -> str:
    """Return thin rules under every cell of a head row that spans several columns."""
    rules, at = [], 1
    for cell in row:
        if cell.span > 1:
            rules.append(rf"\cmidrule(lr){{{at}-{at + cell.span - 1}}}")
        at += cell.span
    return "".join(rules)


# --- contents and outline -------------------------------------------------------------------------


class _Entry(Record):
    """A heading of the contents and the outline; `below` counts the headings directly under it."""

    section: tree.Section
    place: str
    below: int


def _entries(blocks: Sequence[tree.Block]) -> Iterator[_Entry]:
    """Yield the headings of contents and outline, in order."""
    sections = [block for block in blocks if isinstance(block, tree.Section) and block.level <= CONTENTS_LEVEL]
    for index, section in enumerate(sections):
        below = 0
        for later in sections[index + 1 :]:
            if later.level <= section.level:
                break
            below += later.level == section.level + 1
        yield _Entry(section, f"s{index}", below)


def _keys(blocks: Sequence[tree.Block]) -> Iterator[str]:
    """Yield the keys of all blocks that references may name, including those inside lists."""
    for block in blocks:
        if isinstance(block, tree.List):
            for item in block.items:
                yield from _keys(item)
        elif key := getattr(block, "key", ""):
            yield key


def _plain(inlines: tree.Inlines) -> str:
    """Return the words of a title for the outline, which cannot contain formulas."""
    words = []
    for inline in inlines:
        match inline:
            case tree.Text(text) | tree.Reference(text=text):
                words.append(text)
            case tree.Emph(of) | tree.Strong(of):
                words.append(_plain(of))
            case tree.InlineMath(Symbol(base, sub)):
                words.append(base + sub)
            case tree.InlineMath():
                pass
            case _:
                words.append(" ")
    return "".join(words)
