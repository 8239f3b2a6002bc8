"""Which kinds of assignments there are, what each is called, and a file to begin with: all without any mathematics."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path

from reportgen.errors import TemplateError
from reportgen.notation.numbers import Language
from reportgen.sections import sections
from reportgen.words import kind_file, load_words

SAMPLE = "new"
"""The section of a kind's words with the file to begin with."""


@cache
def kinds() -> Mapping[str, str]:
    """The module of every kind, by the name that stands in a file, in alphabetical order."""
    modules = (path.stem for path in sorted((Path(__file__).parent / "catalogue").glob("*.py")))
    named = {module.replace("_", "-"): module for module in modules}
    return {kind: module for kind, module in named.items() if kind_file("vi", kind).is_file()}


def title(name: str, language: Language) -> str:
    """The line of description of a kind, from its words."""
    return str(load_words((kind_file(language, name),))["title"])


def titles(language: Language) -> dict[str, str]:
    """Each kind with its line of description."""
    return {name: title(name, language) for name in kinds()}


def sample(name: str, language: Language) -> str:
    """The commented assignment file to fill in of a kind; raises `KeyError`, `TemplateError` where it has none."""
    if name not in kinds():
        raise KeyError(name)
    file = kind_file(language, name)
    if (section := sections(file).get(SAMPLE)) is None:
        raise TemplateError(f"{file}:1: there is no section {SAMPLE}")
    return section.text
