"""Write a document as a Word file: styles, live fields with results, Word's own formulas, figures in true size.

A section of the file is a run of blocks on the same paper. Numbers of headings are a list of Word's; those of captions
and equations are fields, and references lead to bookmarks around them, so that insertions are renumbered.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import groupby, pairwise

from reportgen import document as tree
from reportgen.base.languages import setting_of
from reportgen.base.records import Record
from reportgen.document import layout
from reportgen.document.alt_text import figure_text
from reportgen.drawing import Scene
from reportgen.formula.formula_layout import NARROW, written
from reportgen.writers.word_elements import (
    A4,
    BOLD,
    CENTRE,
    DECLARED,
    GRID,
    HEAVY,
    ITALIC,
    KEPT,
    LEFT,
    LIGHT,
    PROLOGUE,
    RULED,
    Own,
    PageSetup,
    control,
    drawing,
    field,
    paragraph,
    right_tab,
    rule,
    run,
    section,
    spaced,
    twips,
)
from reportgen.writers.word_math import GAP, Equations, grid_cell, grid_table
from reportgen.writers.word_package import packed
from reportgen.writers.word_sections import CONTENTS_LEVEL, COVER, broken, paged, places, sequence
from reportgen.writers.word_styles import BULLETS, LIST_INDENT, merged, numbering, properties, settings, styles

Pictures = Callable[[Sequence[Scene]], Sequence[tuple[bytes, bytes]]]
"""Function that returns a pair of bytes, PNG and SVG, for each scene."""


def write(
    document: tree.Document, pictures: Pictures, letter: layout.Letter | None = None, own: Own | None = None
) -> bytes:
    """Return the .docx file of a document, byte for byte the same in every run.

    `pictures` draws all scenes at once. `letter` is the font of running text; the default is that of the language. A
    school's `own` styles, header, footer and margins replace the usual ones.
    """
    usual_look = setting_of(document.language)
    letter, own = letter or layout.Letter(usual_look.word.font, usual_look.word.size), own or Own()
    usual = styles(letter.font, letter.size, document.language, document.close, A4.room)
    blocks = _Blocks(document, own.page(usual_look.page))
    body, pages = blocks.sections()
    scenes = pictures(blocks.scenes)
    parts = {
        "document": f"{PROLOGUE}<w:document {DECLARED}><w:body>{body}</w:body></w:document>",
        "styles": merged(usual, own.styles, document.language) if own.styles else usual,
        "numbering": numbering(blocks.starts),
        "settings": settings(document.language),
        "core": properties(document.title, document.author, document.language),
    }
    for index, page in enumerate(pages, start=1):
        parts[f"header{index}"] = own.header or _running("Header", document, page)
        parts[f"footer{index}"] = own.footer or _running("Footer", document, page)
    media = {
        f"figure{index}.{end}": content
        for index, pair in enumerate(scenes, start=1)
        for end, content in zip(("png", "svg"), pair, strict=True)
    }
    return packed(parts, media)


def _running(kind: str, document: tree.Document, page: PageSetup) -> str:
    """Return a header with the report and the current chapter, or a footer with the variant and the page."""
    texts = {
        "Header": (document.header[0], field("STYLEREF 1", "")),
        "Footer": (
            " – ".join(filter(None, (document.footer[0], document.header[1]))),
            run(f"{document.footer[1]} ") + field("PAGE", ""),
        ),
    }
    left, right = texts[kind]
    line = paragraph(kind, run(left) + TAB + right, f"<w:tabs>{right_tab(page.room)}</w:tabs>")
    name = {"Header": "hdr", "Footer": "ftr"}[kind]
    return f"{PROLOGUE}<w:{name} {DECLARED}>{line}</w:{name}>"


EQUATION = "Equation"
"""Name of the counter of equations."""
LINKED = "\\h \\* MERGEFORMAT"
"""Switches of a reference: it is a link, and has the format of the surrounding text, not of a caption."""
TAB, BREAK = "<w:r><w:tab/></w:r>", "<w:r><w:br/></w:r>"
AFTER = paragraph("Gap", "", spaced(0, 10))
"""Space below a table with its caption."""
NEXT_PAGE = paragraph("Gap", '<w:r><w:br w:type="page"/></w:r>')


class _Setting(Record):
    """Context of a block: the level of its list, 0 outside, and True if it stays with the next block."""

    level: int = 0
    kept: bool = False

    @property
    def indent(self) -> float:
        """Indentation of a paragraph at this level (mm)."""
        return LIST_INDENT * self.level

    @property
    def lines(self) -> str:
        """Properties of a paragraph, after its style."""
        return KEPT if self.kept else ""

    @property
    def indented(self) -> str:
        return f'<w:ind w:left="{twips(self.indent)}"/>' if self.level else ""


class _Blocks:
    """Writer of the blocks of one document as WordprocessingML, with everything that they refer to."""

    def __init__(self, document: tree.Document, page: PageSetup) -> None:
        self.page = page
        self.document, self.language, self.words = document, document.language, document.words
        self.setting = setting_of(document.language)
        self.equations = Equations(document.language)
        self.formulas = self.equations.formulas
        self.scenes: list[Scene] = []
        self.starts: list[tuple[int, int]] = []
        """Level and first number of each ordered list."""
        self._marks = 0
        self._figure = ""
        """Key of the figure that is continued, "" if there is none."""
        sections = [block for block in document.blocks if isinstance(block, tree.Section)]
        self.entries = [section for section in sections if section.level <= CONTENTS_LEVEL]
        self._entries = {id(one): f"_Toc{index}" for index, one in enumerate(self.entries, start=1)}
        self.places = dict(places(document.blocks))

    # --- sections of the file ---------------------------------------------------------------------

    def sections(self) -> tuple[str, list[PageSetup]]:
        """Return the body, and the pages that have their own header and footer."""
        runs = [
            (page, [block for _, block in run])
            for (page, _), run in groupby(paged(self.document.blocks, self.page), key=lambda one: one[0])
        ]
        pages = list(dict.fromkeys(page for page, _ in runs if page.running))
        body = []
        for index, (page, blocks) in enumerate(runs, start=1):
            body.append(self.write(broken(blocks)))
            ending = section(page, self.running(page, pages))
            last = index == len(runs)
            # Only a paragraph can end a section.
            body.append(GAP + ending if last else f'<w:p><w:pPr><w:pStyle w:val="Gap"/>{ending}</w:pPr></w:p>')
        return "".join(body), pages

    def running(self, page: PageSetup, pages: Sequence[PageSetup]) -> str:
        """Return the references of a section to its header and footer."""
        if not page.running:
            return ""
        number = pages.index(page) + 1
        kinds = ("header", "footer")
        return "".join(f'<w:{kind}Reference w:type="default" r:id="rel-{kind}{number}"/>' for kind in kinds)

    # --- blocks -----------------------------------------------------------------------------------

    def write(self, blocks: Sequence[tree.Block], level: int = 0) -> str:
        """Return blocks in order; a run-in heading begins the following paragraph."""
        written: list[str] = []
        run_in = ""
        for block, following in pairwise((*blocks, None)):
            assert block is not None
            setting = _Setting(level, layout.leads(block, following, self.language))
            match block:
                case tree.Section(level=depth) if depth > CONTENTS_LEVEL:
                    run_in = self.run_in(block)
                    if not isinstance(following, tree.Paragraph):
                        written.append(paragraph("Normal", run_in, KEPT + setting.indented))
                        run_in = ""
                    continue
                case tree.Paragraph(inlines, align):
                    properties = setting.lines + setting.indented + (f'<w:jc w:val="{align}"/>' if align else "")
                    written.append(paragraph("Normal", run_in + self.inlines(inlines), properties))
                    run_in = ""
                    continue
            if written and written[-1].endswith("</w:tbl>"):
                written.append(GAP)
            written.append(self.block(block, setting))
        if level and written and written[-1].endswith("</w:tbl>"):
            written.append(GAP)
        return "".join(written)

    def block(self, block: tree.Block, setting: _Setting) -> str:
        match block:
            case tree.Section():
                return self.section(block)
            case tree.List():
                return self.listing(block, setting)
            case tree.Equation(rows, key, number):
                numbered = self.counted(EQUATION, number, key, around="(%s)") if number else ""
                return self.equations.displayed(rows, numbered, setting.indent, setting.lines)
            case tree.Table():
                return self.table(block)
            case tree.Figure():
                return self.figure(block)
            case tree.Plate(scene, continues=continues):
                self._figure = self._figure if continues else block.key
                caption = (
                    self.again(block, self.words.continued) if continues else self.caption(self.words.figure, block)
                )
                return self.row([scene], block) + paragraph("Caption", caption)
            case tree.Cover():
                return self.cover(block)
            case tree.Contents(title, brief):
                return self.contents(title, brief)
            case tree.BlankLine(label):
                dots = f"<w:tabs>{right_tab(A4.room, 'dot')}</w:tabs>{LEFT}"
                return paragraph("Normal", run(f"{label} " if label else "") + TAB, dots)
            case tree.Listing(lines):
                return "".join(paragraph("Listing", run(line)) for line in lines)
            case _:
                return NEXT_PAGE

    def section(self, section: tree.Section) -> str:
        title = self.bookmarked(self._entries[id(section)], self.inlines(section.title))
        if section.key:
            title = self.bookmarked(self.places[section.key].bookmark, title)
        # List 0 means no list: a heading outside all lists has no number.
        unnumbered = "" if section.number else '<w:numPr><w:ilvl w:val="0"/><w:numId w:val="0"/></w:numPr>'
        return paragraph(f"Heading{section.level}", title + self.counters(section), unnumbered)

    def counters(self, section: tree.Section) -> str:
        """Return hidden fields that reset the counters of a part, for readers that ignore a sequence's `\\s`."""
        if section.level > 1 or not section.number:
            return ""
        names = (self.words.figure, self.words.table, EQUATION)
        return "".join(field(f"SEQ {sequence(name)} \\h \\r 0", "", "<w:vanish/>") for name in names)

    def run_in(self, section: tree.Section) -> str:
        heading = run(f"{section.number} " if section.number else "", BOLD) + self.inlines(section.title, BOLD)
        marked = self.bookmarked(self.places[section.key].bookmark, heading) if section.key else heading
        return marked + run(" ")

    def bookmarked(self, name: str, content: str) -> str:
        self._marks += 1
        return f'<w:bookmarkStart w:id="{self._marks}" w:name="{name}"/>{content}<w:bookmarkEnd w:id="{self._marks}"/>'

    def listing(self, block: tree.List, setting: _Setting) -> str:
        if block.ordered:
            self.starts.append((setting.level, block.start))
        number = BULLETS + len(self.starts) if block.ordered else BULLETS
        item = f'<w:numPr><w:ilvl w:val="{setting.level}"/><w:numId w:val="{number}"/></w:numPr>'
        paragraphs = []
        for index, blocks in enumerate(block.items, start=1):
            first = blocks[0] if blocks and isinstance(blocks[0], tree.Paragraph) else tree.Paragraph(())
            others = blocks[1:] if blocks and first is blocks[0] else blocks
            leads = layout.leads(first, others[0] if others else None, self.language)
            kept = KEPT if leads or (setting.kept and index == len(block.items)) else ""
            paragraphs.append(paragraph("List", self.inlines(first.inlines), kept + item))
            paragraphs.append(self.write(others, setting.level + 1))
        return "".join(paragraphs)

    def cover(self, cover: tree.Cover) -> str:
        first, *others = (*cover.institution, "")
        lines = [paragraph("Institution", run(first, BOLD))] if first else []
        lines += [paragraph("Institution", run(line)) for line in others if line]
        low = '<w:spacing w:before="{}" w:after="{}"/>'
        lines += [
            paragraph("Title", run(line), "" if index else low.format(twips(52), 200))
            for index, line in enumerate(cover.title)
        ]
        lines += [paragraph("Subtitle", run(line)) for line in cover.subtitle]
        for index, (label, value) in enumerate(cover.fields):
            stops = f'<w:tabs><w:tab w:val="left" w:pos="{twips(58)}"/>{right_tab(COVER.room - 10, "dot")}</w:tabs>'
            white = "" if index else low.format(twips(34), 160)
            hanging = f'<w:ind w:left="{twips(58)}" w:hanging="{twips(48)}"/>'
            entry = run(f"{label}{self.setting.colon.strip()}") + TAB + (run(value, BOLD) if value else TAB)
            lines.append(paragraph("CoverField", entry, stops + white + hanging))
        lines.append(paragraph("Institution", run(cover.place_and_date, ITALIC), low.format(twips(26), 80)))
        return "".join(lines)

    def contents(self, title: str, brief: bool) -> str:
        """Return Word's own table of contents with its entries written; Word computes the page numbers."""
        deepest = CONTENTS_LEVEL - 1 if brief else CONTENTS_LEVEL
        begin, _, end = field(f'TOC \\o "1-{deepest}" \\h \\z', "|").partition(run("|"))
        lines: list[str] = []
        for entry in self.entries:
            if entry.level > deepest:
                continue
            mark = self._entries[id(entry)]
            number = run(entry.number) + TAB if entry.number else ""
            page = TAB + field(f"PAGEREF {mark} \\h", "")
            text = number + self.inlines(entry.title) + page
            link = f'<w:hyperlink w:anchor="{mark}" w:history="1">{text}</w:hyperlink>'
            lines.append(paragraph(f"TOC{entry.level}", link if lines else begin + link))
        if not lines:
            return paragraph("TOCHeading", run(title))
        lines.append(paragraph("Gap", end))
        gallery = '<w:docPartObj><w:docPartGallery w:val="Table of Contents"/><w:docPartUnique/></w:docPartObj>'
        body = paragraph("TOCHeading", run(title)) + "".join(lines)
        return f"<w:sdt><w:sdtPr>{gallery}</w:sdtPr><w:sdtContent>{body}</w:sdtContent></w:sdt>"

    # --- inlines ----------------------------------------------------------------------------------

    def inlines(self, inlines: tree.Inlines, look: str = "") -> str:
        return "".join(self.inline(inline, look) for inline in inlines)

    def inline(self, inline: tree.Inline, look: str) -> str:
        match inline:
            case tree.Text(text):
                return run(text, look)
            case tree.Emph(of):
                return self.inlines(of, look.replace(ITALIC, "") + ITALIC)
            case tree.Strong(of):
                return self.inlines(of, BOLD + look.replace(BOLD, ""))
            case tree.InlineMath(expression, slashed):
                return self.formulas.content(expression, slashed)
            case tree.Value(number):
                return run(written(number, self.language).text(NARROW), look)
            case tree.Reference(key, text):
                place = self.places.get(key)
                return field(f"REF {place.bookmark}{place.switch} {LINKED}", text, look) if place else run(text, look)
            case tree.LineBreak():
                return BREAK
            case tree.Blank():
                return self.bookmarked(inline.called, control(inline.name, inline.title, tree.DOTS))

    def counted(self, name: str, number: str, key: str, look: str = "", around: str = "%s") -> str:
        """Return the number of a caption or an equation as fields, with a bookmark for references to `key`."""
        part, _, last = number.rpartition(".")
        if part:
            fields = field("STYLEREF 1 \\s", part, look) + run(".", look)
            fields += field(f"SEQ {sequence(name)} \\* ARABIC \\s 1", last, look)
        else:
            # In parts without a number, they count through the whole document.
            fields = field(f"SEQ {sequence(name)}_0 \\* ARABIC", last, look)
        opening, closing = (run(mark, look) for mark in around.split("%s"))
        fields = opening + fields + closing
        return self.bookmarked(self.places[key].bookmark, fields) if key else fields

    def caption(self, word: str, block: tree.Table | tree.Figure | tree.Plate) -> str:
        """Return word, number and text of a caption; "" for a block without one."""
        if not (block.number or block.caption):
            return ""
        number = self.counted(word, block.number, block.key, BOLD) if block.number else ""
        stop = run(f"{self.setting.stop} " if block.caption else "", BOLD)
        return run(f"{word} ", BOLD) + number + stop + self.inlines(block.caption)

    def again(self, block: tree.Figure | tree.Plate, where: str) -> str:
        """Return the caption of a continuation from the page before, or of a later part."""
        place = self.places.get(self._figure)
        number = field(f"REF {place.bookmark} {LINKED}", block.number, BOLD) if place else run(block.number, BOLD)
        return run(f"{self.words.figure} ", BOLD) + number + run(self.setting.aside(where), BOLD)

    # --- tables -----------------------------------------------------------------------------------

    def table(self, table: tree.Table) -> str:
        """Return a ruled table below its caption; its head is repeated on each page, a short table is not broken."""
        caption = self.caption(self.words.table, table)
        rows = [self.table_row(row, table, True, index == len(table.head) - 1) for index, row in enumerate(table.head)]
        rows += [
            self.table_row(row, table, False, kept) for row, kept in zip(table.rows, layout.stays(table), strict=True)
        ]
        sides = rule("left", HEAVY), rule("right", HEAVY)
        outer = (rule("top", HEAVY), sides[0], rule("bottom", HEAVY), sides[1], rule("insideH", 0))
        frame = f"<w:tblBorders>{''.join(outer)}</w:tblBorders>" if table.framed else ""
        widths = [column.width for column in table.columns]
        body = grid_table(RULED, widths, f"{CENTRE}{frame}", "".join(rows))
        return (paragraph("Caption", caption, KEPT) if caption else "") + body + AFTER

    def table_row(self, row: Sequence[tree.Cell], table: tree.Table, head: bool, kept_or_last: bool) -> str:
        """Return a row; in the head, the last row and spanning cells have a rule below."""
        cells, at = [], 0
        for cell in row:
            covered = table.columns[at : at + cell.span]
            at += cell.span
            align = "center" if head or not covered else covered[0].align
            kept = KEPT if head or kept_or_last else ""
            content = paragraph("Table", self.inlines(cell.inlines), f'{kept}<w:jc w:val="{align}"/>')
            border = rule("bottom", LIGHT if kept_or_last or cell.span > 1 else 0) if head else ""
            cells.append(grid_cell(content, sum(column.width for column in covered), cell.span, border))
        heading = "<w:tblHeader/>" if head else ""
        return f"<w:tr><w:trPr><w:cantSplit/>{heading}</w:trPr>{''.join(cells)}</w:tr>"

    # --- figures ----------------------------------------------------------------------------------

    def figure(self, figure: tree.Figure) -> str:
        """Return the rows of a figure with the caption below; later parts have the caption of a continuation."""
        self._figure = figure.key
        written = []
        for index, part in enumerate(layout.in_parts(figure), 1):
            where = self.words.part.format(part=index)
            caption = self.again(figure, where) if index > 1 else self.caption(self.words.figure, figure)
            written += [self.row(row, figure) for row in part]
            written.append(paragraph("Caption", caption))
        return "".join(written)

    def row(self, scenes: Sequence[Scene], block: tree.Figure | tree.Plate) -> str:
        """Return scenes side by side, each above its title."""
        drawn = [paragraph("Figure", self.picture(scene, block), KEPT) for scene in scenes]
        titles = [paragraph("FigureTitle", run(scene.title), KEPT) for scene in scenes]
        titled = any(scene.title for scene in scenes)
        if len(scenes) == 1:
            return drawn[0] + (titles[0] if titled else "")
        widths = [scene.width + layout.SCENE_GAP for scene in scenes]
        rows = [drawn, titles] if titled else [drawn]
        lines = (
            "".join(grid_cell(content, width, align="bottom") for content, width in zip(row, widths, strict=True))
            for row in rows
        )
        body = "".join(f"<w:tr><w:trPr><w:cantSplit/></w:trPr>{line}</w:tr>" for line in lines)
        return grid_table(GRID, widths, CENTRE, body) + paragraph("Gap", "", KEPT)

    def picture(self, scene: Scene, block: tree.Figure | tree.Plate) -> str:
        """Return a scene in its true size with its text alternative."""
        self.scenes.append(scene)
        number = len(self.scenes)
        return drawing(number, scene.width, scene.height, figure_text(block, scene, self.words, self.language))
