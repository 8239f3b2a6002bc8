"""The words of a language: compared with those of reference, and set beside them as a proof sheet."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from reportgen.base.errors import Fault, Problem
from reportgen.base.template_folders import languages, templates
from reportgen.base.units import Language
from reportgen.base.words import as_problem
from reportgen.report.translation import faults
from reportgen.writers.typst_fonts import lacking

BATCH = 400
"""So many letters are asked for at a time."""
WARNINGS = frozenset({"words-term", "words-untranslated"})
"""What may be meant so: a term said otherwise than in the glossary, a message that comes in English."""


def folder_of(place: str) -> Path:
    """The folder of a language, by its name or as a way to it; it may not be there."""
    return templates() / place if place in languages() else Path(place)


def compared(folder: Path, language: Language) -> list[Problem]:
    """What the words of a folder lack or have otherwise than those of reference, told in a language.

    Raises `TemplateError` for what cannot be read.
    """
    return [_problem(fault, language) for fault in faults(folder, _lacking)]


def _problem(fault: Fault, language: Language) -> Problem:
    return as_problem(fault, language, "warning" if fault.code in WARNINGS else "error")


def _lacking(letters: str) -> str:
    return "".join(_in_batches(letters))


def _in_batches(letters: str) -> Iterator[str]:
    for start in range(0, len(letters), BATCH):
        yield lacking(letters[start : start + BATCH], True)
