"""Words: templates of plain Markdown with Jinja names, rendered to blocks of the tree."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from reportgen import installation
from reportgen.document.tree import Block, Inlines
from reportgen.notation.numbers import Language

if TYPE_CHECKING:
    from jinja2 import Environment

ENVIRONMENTS = 8
"""How many search paths (language, kind, school) keep their compiled templates."""


def search_path(
    language: Language, kind: str = "", school: str = "", root: Path | None = None
) -> tuple[Path, ...]:
    """Where a template of words is looked for, the first found wins.

    A school's own words, then those of one kind of machine, then those common to all.
    """
    root = root or installation.templates()
    return (
        *((root / school / language,) if school else ()),
        *((root / language / kind,) if kind else ()),
        root / language,
    )


class Prose:
    """Renders the templates found in `directories`; one object serves a whole report.

    Every template may call `ref(key)`, `key(name)` and `unnumbered()` (at the end of a heading),
    `blank(label)`, and `inlines(words)` for what a macro or a `{% set %}` block made.
    """

    def __init__(self, directories: tuple[Path, ...]) -> None:
        self.directories = directories

    def render(self, name: str, names: Mapping[str, object]) -> tuple[Block, ...]:
        """The blocks of the template `name` ("foreword.md") with `names` filled in.

        Strings appear as they are, expressions as formulas, numbers with their unit, inlines and blocks
        as themselves, sequences item by item.  Raises `TemplateError` (`file:line: message`) on any fault.
        """
        from reportgen.document import fragments, markdown

        return markdown.blocks(fragments.render(_environment(self.directories), name, names))

    def inlines(self, words: str) -> Inlines:
        """What a macro, `caller()` or a `{% set %}` block made, as inlines: a caption written in a template.

        For functions called by a template while it is rendered; a plain string becomes plain text.
        """
        return _inlines(words)


def _inlines(words: str) -> Inlines:
    from reportgen.document import fragments, markdown

    return markdown.inlines(fragments.excerpt(words))


@lru_cache(maxsize=ENVIRONMENTS)
def _environment(directories: tuple[Path, ...]) -> Environment:
    """Kept from report to report, with the templates compiled; a template that was changed is read again."""
    from reportgen.document import fragments

    result = fragments.environment(directories)
    result.globals["inlines"] = _inlines
    return result
