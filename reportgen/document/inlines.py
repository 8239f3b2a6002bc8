"""The inlines of a line: texts, formulas, values and references.

Texts are plain strings exactly as they appear in print; writers escape them.
"""

from __future__ import annotations

from reportgen.base.records import record
from reportgen.formula import Expression, Number


@record
class Text:
    """Plain text."""

    text: str


@record
class Emph:
    """Emphasised inlines, printed in italics."""

    of: tuple[Inline, ...]


@record
class Strong:
    """Strong inlines, printed in bold."""

    of: tuple[Inline, ...]


@record
class InlineMath:
    """A symbol or a short formula inside a line; `slashed` fractions keep the height of the line: 3 l/2."""

    expression: Expression
    slashed: bool = False


@record
class Value:
    """A number with its unit inside a line or a table cell."""

    number: Number


@record
class Reference:
    """The number of the block called `key`, linked; `text` is filled in by numbering."""

    key: str
    text: str = ""


@record
class LineBreak:
    """The end of a line inside a paragraph."""


@record
class Blank:
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
