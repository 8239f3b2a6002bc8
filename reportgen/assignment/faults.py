"""Faults of input files, and the messages that put them into words.

The messages stand in `templates/<language>/messages.yaml`, with all that the command line says.
"""

from __future__ import annotations

import difflib
import unicodedata
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from string import Formatter
from typing import Any, Literal

from reportgen import installation
from reportgen.errors import AssignmentError, Mark, Problem
from reportgen.notation.numbers import Language

DEFAULT_LANGUAGE: Language = "vi"
LONGEST_SHOWN = 40

Where = tuple[str | int, ...]
"""A place in the content of a file: keys and list indices from the top."""


@dataclass(frozen=True, slots=True)
class Fault:
    """A fault at a place in the text; `arguments` fill the message named by `code`.

    An argument `hint` names the hint to give instead of the code's own.
    """

    code: str
    mark: Mark
    arguments: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Finding:
    """A fault of the content, found where marks are not known: at a value or at its key."""

    code: str
    where: Where
    arguments: Mapping[str, str] = field(default_factory=dict)
    at: Literal["value", "key"] = "value"


@cache
def messages(language: Language) -> Mapping[str, Any]:
    """The message table: `faults`, `hints`, `words` (kinds of value, reasons), `columns` and `cli`."""
    # Reading a YAML file finds faults, so that module imports this one.
    from reportgen.assignment.source import words_of

    return words_of(installation.templates() / language / "messages.yaml")


def word(key: str, language: Language | None, /, **arguments: object) -> str:
    """A text of the command line with its arguments filled in."""
    return str(messages(language or DEFAULT_LANGUAGE)["cli"][key]).format(**arguments)


def unexpected(error: BaseException, language: Language | None) -> str:
    """A fault of the program itself, in one line."""
    return word("unexpected", language, name=type(error).__name__, text=" ".join(str(error).split()))


def as_problem(fault: Fault, language: Language | None) -> Problem:
    """The fault in words; its hint is given when the arguments it speaks of are known."""
    table = messages(language or DEFAULT_LANGUAGE)
    arguments = {name: _shown(text) for name, text in fault.arguments.items()}
    for name in arguments.keys() & {"expected", "reason"}:
        arguments[name] = str(table["words"].get(fault.arguments[name], arguments[name]))
    message = str(table["faults"][fault.code]).format_map(arguments)
    # The hint that was asked for, then the code's own and its second form.
    keys = (fault.arguments.get("hint"), fault.code, f"{fault.code}-otherwise")
    hints = (str(table["hints"][key]) for key in keys if table["hints"].get(key))
    hint = next((hint for hint in hints if _fields(hint) <= arguments.keys()), None)
    return Problem(fault.code, message, fault.mark, hint.format_map(arguments) if hint else None)


def as_error(faults: Iterable[Fault], language: Language | None) -> AssignmentError:
    """The error that carries these faults in words, each once."""
    return AssignmentError(list(dict.fromkeys(as_problem(fault, language) for fault in faults)))


def close_or_known(key: str, known: Sequence[str]) -> dict[str, str]:
    """What to say of an unknown key: the known one it was probably meant to be, or all that are known."""
    same = [name for name in known if name.casefold() == key.casefold()]
    close = difflib.get_close_matches(key, known, n=1, cutoff=0.6) or same
    return {"close": close[0]} if close else {"known": ", ".join(known)}


def _fields(template: str) -> set[str]:
    return {name for _, name, _, _ in Formatter().parse(template) if name}


def _shown(text: str) -> str:
    """A piece of the file as it can stand in a message: one line, no control characters, not endless."""
    clean = "".join("\N{REPLACEMENT CHARACTER}" if unicodedata.category(c) in {"Cc", "Cs"} else c for c in text)
    return clean if len(clean) <= LONGEST_SHOWN else f"{clean[:LONGEST_SHOWN]}…"
