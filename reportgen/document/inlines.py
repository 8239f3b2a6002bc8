"""The inlines of a line: texts, formulas, values and references.

Texts are plain strings exactly as they appear in print; writers escape them.
"""

from __future__ import annotations

from reportgen.base.records import Record
from reportgen.formula import Expression, Number


class Text(Record):
    """Plain text."""

    text: str


class Emph(Record):
    """Emphasised inlines, printed in italics."""

    of: tuple[Inline, ...]


class Strong(Record):
    """Strong inlines, printed in bold."""

    of: tuple[Inline, ...]


class InlineMath(Record):
    """A symbol or a short formula inside a line; `slashed` fractions keep the height of the line: 3 l/2."""

    expression: Expression
    slashed: bool = False


class Value(Record):
    """A number with its unit inside a line or a table cell."""

    number: Number


class Reference(Record):
    """The number of the block called `key`, linked; `text` is filled in by numbering."""

    key: str
    text: str = ""


class LineBreak(Record):
    """The end of a line inside a paragraph."""


class Blank(Record):
    """A place to fill in.

    `name` is the name of the value, `called` a shorter one for systems with limited names, and `title` the title of the
    field in a Word document.
    """

    name: str
    called: str
    title: str = ""


DOTS = "……"
"""Text printed for a blank."""

Inline = Text | Emph | Strong | InlineMath | Value | Reference | LineBreak | Blank
Inlines = tuple[Inline, ...]
