"""The text of a Word report as lines of letters, each with its element.

Indices and exponents are in braces (`v_{B}`), built-up formulas are linearised. Invisible text is left out: deleted and
struck-out text, hidden text, letters without width.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from reportgen.base.errors import Location
from reportgen.base.typed_characters import DOTS, MINUSES, UNSEEN
from reportgen.handin.word_nodes import XmlNode

OBJECT = "\ufffc"
"""Placeholder of an equation from another program, which cannot be opened."""
APART = "\u2005"
"""Separator before and after a built-up formula, so that two adjacent ones stay separate."""
LONGEST = 20_000
"""Largest number of characters of a line that is read."""


class WordLocation(Location):
    """A paragraph of a Word file, counted from 1, and the number of the element with the value."""

    element: int = 0

    def __str__(self) -> str:
        return f"{self.file}:¶{self.line}"


@dataclass(slots=True)
class TextLine:
    """A paragraph as text; `nodes` has the element of each letter.

    `level` is that of a heading, 0 for any other paragraph; `bold` is True if all of it is bold.
    """

    number: int
    level: int = 0
    bold: bool = False
    letters: list[str] = field(default_factory=list)
    nodes: list[XmlNode] = field(default_factory=list)
    everything: bool = False
    """True if invisible text is included."""

    @property
    def text(self) -> str:
        """The letters as a string."""
        return "".join(self.letters)

    def put(self, text: str, node: XmlNode) -> None:
        """Append letters in normalised form, without letters of no width."""
        for letter in text:
            for plain in LETTERS.get(letter, letter):
                self.letters.append(plain)
                self.nodes.append(node)

    def extend(self, line: TextLine) -> None:
        """Append the letters of another line, with their elements."""
        self.letters += line.letters
        self.nodes += line.nodes


@dataclass(slots=True)
class TextGrid:
    """A table as rows of cells; a merged cell occurs in each of its rows and columns."""

    rows: list[list[TextCell]]


@dataclass(slots=True, eq=False)
class TextCell:
    """A cell: its paragraphs, and the tables in it."""

    lines: list[TextLine]
    blocks: list[TextLine | TextGrid]

    @property
    def line(self) -> TextLine:
        """All its paragraphs in one line, separated by line breaks."""
        joined = TextLine(self.lines[0].number if self.lines else 0)
        for number, line in enumerate(self.lines):
            if number and line.nodes:
                joined.put("\n", line.nodes[0])
            joined.extend(line)
        return joined


WordBlock = TextLine | TextGrid


def _letters() -> dict[str, str]:
    """Return a table that maps similar letters to one of them, and invisible ones to ""."""
    letters = {
        **dict.fromkeys((*UNSEEN, "\u20d7", "\u0305"), ""),
        **dict.fromkeys(MINUSES, "-"),
        **dict.fromkeys(DOTS, "·"),
    }
    letters |= {"’": "′", "'": "′", "‘": "′", "ʹ": "′", "″": "′′", "”": "′′", '"': "′′", "‴": "′′′"}
    letters |= {"µ": "μ", "ϕ": "φ", "ɸ": "φ", "ϵ": "ε", "ϑ": "θ", "∗": "*"}
    letters |= {chr(code): chr(code - 0xFEE0) for code in range(0xFF01, 0xFF5F)}
    # Chinese punctuation includes its blank.
    letters |= {"，": ", ", "、": ", ", "；": "; ", "：": ": ", "。": ". ", "（": " (", "）": ") "}
    letters |= {"＝": "=", "≅": "≈", "≃": "≈", "≒": "≈", "∼": "~"}
    letters |= {"⟹": "⇒", "⟶": "→", "➔": "→", "➜": "→"}
    letters |= {chr(code): str(code - 0x2080) for code in range(0x2080, 0x208A)}
    letters |= dict(zip("ₐₑₒₓₕₖₗₘₙₚₛₜᵢⱼᵣᵤᵥ", "aeoxhklmnpstijruv", strict=True))
    # Mathematical letters in italics, bold and so on.
    for first, last, start in ((0x1D400, 0x1D6A3, 52), (0x1D6A8, 0x1D7C9, 58)):
        for code in range(first, last + 1):
            place = (code - first) % start
            if start == 52:
                letters[chr(code)] = chr(ord("A" if place < 26 else "a") + place % 26)
            elif 26 <= place <= 50:
                letters[chr(code)] = chr(0x3B1 + place - 26)
    letters |= {"ℎ": "h"}
    return letters


LETTERS: Mapping[str, str] = _letters()
_SYMBOL_FONT = dict(zip("abcdefghijklmnopqrstuvwxyz", "αβχδεφγηιφκλμνοπθρστυϖωξψζ", strict=True)) | {
    "D": "Δ",
    "W": "Ω",
    "S": "Σ",
    "F": "Φ",
    "\xb0": "°",
    "\xb7": "·",
    "\xb4": "×",
    "\xbb": "≈",
    "\xde": "⇒",
    "\xae": "→",
    "\xa2": "′",
    "\xb2": "′′",
}
"""Letters that the font Symbol shows."""
_UNSEEN = frozenset({"w:del", "w:moveFrom", "w:rPr", "w:pPr", "w:instrText", "w:delText", "m:phant", "w:sdtPr"})
_OFF = frozenset({"0", "false", "off", "none"})
_EQUATIONS = re.compile(r"equation|mathtype", re.IGNORECASE)


class TextReader:
    """Reads the body of a document into blocks in order."""

    def __init__(self, levels: Mapping[str, int], everything: bool = False) -> None:
        """Create a reader; with `everything` it also reads invisible text."""
        self.everything = everything
        self.levels = levels
        """Levels of headings by the ids of styles."""
        self.paragraphs = 0

    def blocks(self, nodes: Iterable[XmlNode]) -> Iterator[WordBlock]:
        """Yield paragraphs and tables, also those in content controls and in text boxes, which follow their line."""
        for node in nodes:
            if node.tag == "w:p":
                line = self.line(node)
                yield line
                for box in _boxes(node):
                    yield from self.blocks(box.children)
            elif node.tag == "w:tbl":
                yield self.grid(node)
            elif node.tag in ("w:sdt", "w:sdtContent", "w:customXml", "w:ins", "w:moveTo", "mc:Choice"):
                yield from self.blocks(node.children)
            elif node.tag == "mc:AlternateContent":
                yield from self.blocks(node.children[:1])

    def line(self, paragraph: XmlNode) -> TextLine:
        """Return a paragraph as a line."""
        self.paragraphs += 1
        style = paragraph.at("w:pPr", "w:pStyle")
        own = paragraph.at("w:pPr", "w:outlineLvl")
        level = self.levels.get(style.get("w:val"), 0) if style else 0
        if own is not None and own.get("w:val").isdecimal() and int(own.get("w:val")) < 9:
            level = int(own.get("w:val")) + 1
        line = TextLine(self.paragraphs, level, everything=self.everything)
        runs = [node for node in _within(paragraph) if node.tag == "w:r" and any(c.tag == "w:t" for c in node.children)]
        line.bold = bool(runs) and all(_is_on(run, "w:b") for run in runs)
        put(paragraph.children, line)
        if len(line.letters) > LONGEST:
            del line.letters[LONGEST:], line.nodes[LONGEST:]
        return line

    def grid(self, table: XmlNode) -> TextGrid:
        """Return a table with its merged cells in all their places."""
        rows: list[list[TextCell]] = []
        for tr in _through(table, "w:tr"):
            row: list[TextCell] = []
            for tc in _through(tr, "w:tc"):
                span, merged = tc.at("w:tcPr", "w:gridSpan"), tc.at("w:tcPr", "w:vMerge")
                width = int(span.get("w:val")) if span is not None and span.get("w:val").isdecimal() else 1
                goes_on = merged is not None and merged.get("w:val", "continue") == "continue"
                above = rows[-1][len(row)] if goes_on and rows and len(row) < len(rows[-1]) else None
                inner = list(self.blocks(tc.children))
                cell = above or TextCell([one for one in inner if isinstance(one, TextLine)], inner)
                row += [cell] * min(max(width, 1), 64)
            rows.append(row)
        return TextGrid(rows)


def _through(node: XmlNode, tag: str) -> Iterator[XmlNode]:
    """Yield the rows of a table, or the cells of a row, including those in content controls."""
    for child in node.children:
        if child.tag == tag:
            yield child
        elif child.tag in ("w:sdt", "w:sdtContent", "w:customXml", "w:ins"):
            yield from _through(child, tag)


def _within(node: XmlNode) -> Iterator[XmlNode]:
    """Yield all visible elements of a paragraph, except those in boxes."""
    for child in node.children:
        if child.tag not in _UNSEEN and child.tag not in ("w:drawing", "w:pict", "mc:AlternateContent"):
            yield child
            yield from _within(child)


def _boxes(paragraph: XmlNode) -> Iterator[XmlNode]:
    """Yield the text boxes of a paragraph; if there are versions for old and new programs, the new one."""
    pending = list(reversed(paragraph.children))
    while pending:
        node = pending.pop()
        if node.tag == "w:txbxContent":
            yield node
        elif node.tag == "mc:AlternateContent":
            pending += node.children[:1]
        elif node.tag not in _UNSEEN:
            pending += reversed(node.children)


def _is_on(run: XmlNode, name: str) -> bool:
    switch = run.at("w:rPr", name)
    return switch is not None and switch.get("w:val", "1") not in _OFF


def is_unseen(run: XmlNode, everything: bool = False) -> bool:
    """Return True if the text of a run is struck out or, unless `everything` is read, invisible."""
    names = ("w:strike", "w:dstrike") if everything else ("w:vanish", "w:strike", "w:dstrike")
    return any(_is_on(run, name) for name in names) or (run.unseen and not everything)


def put(nodes: Iterable[XmlNode], line: TextLine) -> None:
    """Append the text of a paragraph's elements to a line."""
    for child in nodes:
        if child.tag == "w:r":
            _put_run(child, line)
        elif child.tag in ("m:oMath", "m:oMathPara"):
            if child.tag == "m:oMath":
                line.put(APART, child)
                _put_math(child, line)
                line.put(APART, child)
            else:
                put(child.children, line)
        elif child.tag not in _UNSEEN:
            put(child.children, line)


def _put_run(run: XmlNode, line: TextLine) -> None:
    if is_unseen(run, line.everything):
        return
    raised = _raised(run)
    text = "".join(_text_of(child, run) for child in run.children)
    if text.strip() and raised:
        text = f"{raised}{{{text}}}"
    line.put(text, run)


def _text_of(child: XmlNode, run: XmlNode) -> str:
    match child.tag:
        case "w:t":
            fonts = run.at("w:rPr", "w:rFonts")
            greek = fonts is not None and fonts.get("w:ascii").casefold() == "symbol"
            return "".join(_SYMBOL_FONT.get(one, one) for one in child.text) if greek else child.text
        case "w:sym":
            return _symbol(child)
        case "w:tab":
            return "\t"
        case "w:br" | "w:cr":
            return "\n"
        case "w:noBreakHyphen":
            return "-"
        case "w:object" | "w:pict":
            objects = (one for one in child.walk() if one.tag == "o:OLEObject")
            return OBJECT if any(_EQUATIONS.search(one.get("ProgID")) for one in objects) else ""
    return ""


def _symbol(node: XmlNode) -> str:
    """Return a single inserted letter of the font Symbol."""
    code = node.get("w:char")
    if node.get("w:font").casefold() != "symbol" or not re.fullmatch("[0-9A-Fa-f]{4}", code):
        return ""
    letter = chr(int(code, 16) & 0xFF)
    return _SYMBOL_FONT.get(letter, letter)


def _raised(run: XmlNode) -> str:
    """Return "_" for an index, "^" for an exponent, "" for text on the base line."""
    align, position = run.at("w:rPr", "w:vertAlign"), run.at("w:rPr", "w:position")
    if align is not None:
        return {"subscript": "_", "superscript": "^"}.get(align.get("w:val"), "")
    moved = position.get("w:val") if position is not None else ""
    return "_" if re.fullmatch("-[1-9][0-9]*", moved) else "^" if re.fullmatch("[1-9][0-9]*", moved) else ""


# --- built formulas -------------------------------------------------------------------------------


def _put_math(node: XmlNode, line: TextLine) -> None:
    for child in node.children:
        _put_built(child, line)


def _put_built(node: XmlNode, line: TextLine) -> None:
    """Append a built-up formula to a line."""

    def part(name: str) -> None:
        if (inner := node.child(name)) is not None:
            _put_math(inner, line)

    def marked(opening: str, name: str, closing: str) -> None:
        line.put(opening, node)
        part(name)
        line.put(closing, node)

    match node.tag:
        case "m:r":
            if not is_unseen(node, line.everything):
                for child in node.children:
                    if child.tag in ("m:t", "w:t"):
                        line.put(child.text, node)
        case "w:r":
            _put_run(node, line)
        case "m:f":
            marked("(", "m:num", ")/")
            marked("(", "m:den", ")")
        case "m:sSub" | "m:sSup" | "m:sSubSup" | "m:sPre":
            part("m:e")
            for name, sign in (("m:sub", "_{"), ("m:sup", "^{")):
                if node.child(name) is not None:
                    marked(sign, name, "}")
        case "m:rad":
            marked("√(", "m:e", ")")
        case "m:d":
            _put_fence(node, line)
        case "m:eqArr" | "m:m":
            for number, row in enumerate(one for one in node.children if one.tag in ("m:e", "m:mr")):
                line.put("\n" if number else "", node)
                _put_math(row, line)
        case "m:limLow" | "m:limUpp" | "m:nary":
            # Sums and integrals contain values that are not results.
            line.put("∑(", node)
            part("m:e")
            line.put(")", node)
        case tag if tag.endswith("Pr") or tag in _UNSEEN:
            pass
        case _:
            _put_math(node, line)


def _put_fence(node: XmlNode, line: TextLine) -> None:
    """Append parentheses, bars and similar delimiters with their content."""

    def sign(name: str, usual: str) -> str:
        given = node.at("m:dPr", name)
        return usual if given is None else given.get("m:val", "")

    line.put(sign("m:begChr", "("), node)
    for number, inner in enumerate(child for child in node.children if child.tag == "m:e"):
        line.put(sign("m:sepChr", "|") if number else "", node)
        _put_math(inner, line)
    line.put(sign("m:endChr", ")"), node)


def heading_levels(styles: XmlNode) -> dict[str, int]:
    """Return the levels of headings by the ids of the heading styles and of styles based on them."""
    based: dict[str, str] = {}
    levels: dict[str, int] = {}
    for style in styles.children:
        if style.tag != "w:style":
            continue
        id, name = style.get("w:styleId"), style.child("w:name")
        heading = re.fullmatch(r"heading ([1-9])", name.get("w:val").casefold()) if name is not None else None
        outline, parent = style.at("w:pPr", "w:outlineLvl"), style.child("w:basedOn")
        if heading:
            levels[id] = int(heading[1])
        elif outline is not None and re.fullmatch("[0-8]", outline.get("w:val")):
            levels[id] = int(outline.get("w:val")) + 1
        elif parent is not None:
            based[id] = parent.get("w:val")
    for id in based:
        seen, parent_id = {id}, based[id]
        while parent_id in based and parent_id not in seen:
            seen.add(parent_id)
            parent_id = based[parent_id]
        if parent_id in levels:
            levels[id] = levels[parent_id]
    return levels
