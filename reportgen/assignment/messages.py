"""Faults and the command line's words in the reader's language, from `templates/<language>/messages.yaml`."""

from __future__ import annotations

import unicodedata
from collections.abc import Mapping
from functools import cache
from string import Formatter
from typing import Any

from reportgen import folders
from reportgen.assignment.faults import Fault
from reportgen.assignment.source import words_of
from reportgen.errors import Problem
from reportgen.notation.numbers import Language

LONGEST_SHOWN = 40


@cache
def messages(language: Language) -> Mapping[str, Any]:
    """The message table: `faults`, `hints`, `words` (kinds of value, reasons) and `cli`."""
    return words_of(folders.templates() / language / "messages.yaml")


def as_problem(fault: Fault, language: Language) -> Problem:
    """The fault in words; its hint is given when the arguments it speaks of are known."""
    table = messages(language)
    arguments = {name: _shown(text) for name, text in fault.arguments.items()}
    for name in arguments.keys() & {"expected", "reason"}:
        arguments[name] = str(table["words"].get(fault.arguments[name], arguments[name]))
    message = str(table["faults"][fault.code]).format_map(arguments)
    hints = (table["hints"].get(key) for key in _hint_keys(fault))
    hint = next((str(text) for text in hints if text and _fields(str(text)) <= arguments.keys()), None)
    return Problem(fault.code, message, fault.mark, hint.format_map(arguments) if hint else None)


def word(name: str, language: Language) -> str:
    """A word of the command line."""
    return str(messages(language)["cli"][name])


def _hint_keys(fault: Fault) -> tuple[str, ...]:
    """Names of hints to try: the one asked for, then the code's own and its second form."""
    asked = (fault.arguments["hint"],) if "hint" in fault.arguments else ()
    return (*asked, fault.code, f"{fault.code}-otherwise")


def _fields(template: str) -> set[str]:
    return {name for _, name, _, _ in Formatter().parse(template) if name}


def _shown(text: str) -> str:
    """A piece of the file as it can stand in a message: one line, no control characters, not endless."""
    clean = "".join(
        "\N{REPLACEMENT CHARACTER}" if unicodedata.category(c) in {"Cc", "Cs"} else c for c in text
    )
    return clean if len(clean) <= LONGEST_SHOWN else f"{clean[:LONGEST_SHOWN]}…"
