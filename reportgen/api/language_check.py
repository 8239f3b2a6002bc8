"""Check the words of a language against the reference, and typeset them side by side as a proof sheet."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from reportgen import catalogue
from reportgen.api import typeset
from reportgen.base.errors import AssignmentError, Fault, Location, Problem
from reportgen.base.languages import read_setting
from reportgen.base.template_folders import LANGUAGE_FILE, REFERENCE, languages, templates
from reportgen.base.units import Language
from reportgen.base.words import as_problem, common_words, messages, spoken
from reportgen.cases import MachineCase, open_case
from reportgen.document.proof_sheet import proof
from reportgen.document.translation_check import faults
from reportgen.report.context import ReportContext
from reportgen.writers.typst_fonts import added, lacking, there_is_one_of

BATCH = 400
"""Number of letters in one query."""
WARNINGS = frozenset({"words-term", "words-untranslated", "words-idle"})
"""Codes of harmless findings: another term than the glossary's, a message in English, an unused word."""


def folder_of(place: str) -> Path:
    """Return the folder of a language, by its name or as a path; it may not exist."""
    return templates() / place if place in languages() else Path(place)


def compared(folder: Path, language: Language) -> list[Problem]:
    """Return the differences between the words of a folder and the reference, worded in a language.

    Raises `TemplateError` for a file that cannot be read.
    """
    wanted = read_setting(file).typst.fonts if (file := folder / LANGUAGE_FILE).is_file() else ()
    if wanted and not there_is_one_of(wanted):
        # Without its fonts, nearly every line would be reported.
        missing = Fault("no-letters", Location(str(file)), {"text": folder.name, "known": ", ".join(wanted)})
        return [_problem(fault, language) for fault in (missing, *faults(folder))]
    return [_problem(fault, language) for fault in faults(folder, _lacking)]


def _problem(fault: Fault, language: Language) -> Problem:
    return as_problem(fault, language, "warning" if fault.code in WARNINGS else "error")


def _lacking(letters: str) -> str:
    return "".join(_in_batches(letters))


def _in_batches(letters: str) -> Iterator[str]:
    for start in range(0, len(letters), BATCH):
        yield lacking(letters[start : start + BATCH], True, added())


# --- the proof sheet ----------------------------------------------------------------------------------

PROOF = "proof.pdf"
COMMON = "engine-twin"
"""The machine whose data are used for the words common to all machines: it has gas, forces and a flywheel."""


def proof_sheet(folder: Path, language: Language) -> bytes:
    """Return the proof sheet of a language as PDF; raise `TypesetterError`, and `TemplateError` for faulty words."""
    # Words that the language lacks are shown in the reference language.
    words = {**common_words(REFERENCE), **common_words(language), **messages(spoken())["proof"]}
    return typeset(proof(folder, language, words, _names), "typst")[1]


def _names(kind: str, language: Language) -> Mapping[str, object]:
    """Return the template names for the first example of a kind; {} for a kind that is not a machine."""
    from reportgen.report.template_names import names

    examples = catalogue.examples(kind or COMMON)
    try:
        case = open_case(next(iter(examples.values())), language)
    except (AssignmentError, StopIteration):
        return {}
    if not isinstance(case, MachineCase):
        return {}
    return {**names(ReportContext(case)), "k": case.assignment.worked_positions[0]}
