"""What an assignment comes to, whatever kind of work it is: the one thing that every output is made of.

Whoever makes files, marks or draws a class asks a `Case` and nothing else, and never which kind of case it is.  A
machine is one implementation (`reportgen.cases`), an exercise of plane motion another; a further kind of work is one
more and changes nobody else.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from reportgen.assignment import Assignment
from reportgen.document.key import Key
from reportgen.document.tree import Document
from reportgen.figures.moving import Film
from reportgen.figures.sheet import Sheet
from reportgen.ledger.core import Ledger
from reportgen.notation.sheet import Family


@dataclass(frozen=True, slots=True)
class Pitfalls:
    """What of an assignment is easily taken for something else; marking looks for it.

    `applied` are the given loads by name, `loads` all of them, each of which may be forgotten or reversed.  `readings`
    are for a quantity that is read from a diagram the values [N] that it has when it is read wrongly, with the
    mistake's name.  `whole` is for a length from one end of a rod the length of the whole rod, by ids.
    """

    applied: frozenset[str] = frozenset()
    loads: tuple[str, ...] = ()
    readings: Mapping[str, Sequence[tuple[str, np.ndarray]]] = field(default_factory=dict)
    whole: Mapping[str, str] = field(default_factory=dict)


class Case(Protocol):
    """An assignment opened once; each part is computed when it is first asked for.

    Making a part raises `TemplateError` for a fault in the words, and `NotOfferedError` for what this kind has not.
    """

    @property
    def assignment(self) -> Assignment: ...

    @property
    def words(self) -> Mapping[str, Any]:
        """The short words of its language, kind and school."""

    @property
    def title(self) -> str:
        """What its kind is called, in its language."""

    @property
    def ledger(self) -> Ledger:
        """Every number by its id."""

    @property
    def families(self) -> Mapping[str, Family]:
        """What is worked out at its positions, before decimals are chosen."""

    @property
    def positions_of_a_turn(self) -> int:
        """After so many positions motion repeats."""

    @property
    def speed(self) -> float | None:
        """Of its driver (rad/s or m/s); None where nothing drives it."""

    @property
    def balance(self) -> np.ndarray | None:
        """The torque or force on the driver that balances the loads [N]; None without loads."""

    @property
    def pitfalls(self) -> Pitfalls:
        """What marking looks for beside the mistakes that any formula may have."""

    def fault(self) -> str:
        """The code of a fault that shows only in the results, "" if they are sound; variants are judged by it."""

    def document(self) -> Document:
        """The finished, numbered report."""

    def key(self) -> Key:
        """The answer key, from the ledger that the report prints."""

    def task(self, key: Key, by_section: bool = False) -> Document:
        """What a student is handed, from the given data to the empty answer sheet of `key`; no answer is in it.

        `by_section` puts each section of the sheet on pages of its own, headed by whose it is.
        """

    def results(self) -> dict[str, Any]:
        """The contract's JSON object: an entry a position, null where it cannot be reached."""

    def film(self) -> Film | None:
        """What moves on its page, if anything does."""

    def sheets(self, size: str = "", sets: Collection[str] = (), block: Path | None = None) -> list[Sheet]:
        """Its drawing sheets; raises `SheetError` where there is nothing to draw or a plate is too large."""
