"""Faults before they are put into words."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from reportgen.errors import Mark

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
