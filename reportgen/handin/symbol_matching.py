"""Symbols of a key as students write them, and the rows that they refer to."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property

from reportgen.case.answer_key import Key, KeyRow
from reportgen.handin.word_text import LETTERS
from reportgen.marking.toleranced_key import symbol_text

_MARKS = re.compile(r"[\s_^{}|]")
_BRACES = re.compile(r"[\s{}|]")
_POWER = re.compile(r"\^\{?(\d+)\}?")
"""An exponent as in v_B^2, which is not v_B2."""
_ROUND = re.compile(r"\(\d\)$")
"""The number after a quantity that is computed twice, M_cb^(1)."""
_SPELLED: Mapping[str, str] = {
    "omega": "ω",
    "epsilon": "ε",
    "eps": "ε",
    "alpha": "α",
    "beta": "β",
    "mu": "μ",
    "phi": "φ",
    "psi": "ψ",
    "theta": "θ",
    "tau": "τ",
}
_LATIN = str.maketrans("ωμεατ", "wueat")
"""Substitutes for Greek letters on a keyboard without them."""


def bare(text: str) -> str:
    """Return a symbol without marks of index or exponent: v_{BA}, v_BA and vBA are equal."""
    return _MARKS.sub("", _POWER.sub(r"↑\1", "".join(LETTERS.get(letter, letter) for letter in text)))


def _latin(text: str) -> str:
    return text.casefold().translate(_LATIN)


_LOOSER: Sequence[Callable[[str], str]] = (str.casefold, _latin)


class Symbols:
    """All symbols of a key, and the requested rows that each of them refers to."""

    def __init__(self, key: Key, rows: Iterable[KeyRow]) -> None:
        """Create the symbols of `rows`, the rows of the part of the key that is searched."""
        self.key = key
        self.rows = tuple(rows)

    @cached_property
    def every(self) -> dict[str, tuple[KeyRow, ...]]:
        """The rows by their symbols, requested or not."""
        every: dict[str, tuple[KeyRow, ...]] = {}
        for row in self.rows:
            text = bare(symbol_text(row, self.key))
            every[text] = (*every.get(text, ()), row)
        return every

    @cached_property
    def _round(self) -> dict[str, tuple[KeyRow, ...]]:
        """The rows that are computed several times, by the common stem of their symbols."""
        common: dict[str, tuple[KeyRow, ...]] = {}
        for text, rows in self.every.items():
            if _ROUND.search(text):
                head = _ROUND.sub("", text)
                common[head] = (*common.get(head, ()), *rows)
        return common

    @cached_property
    def _known(self) -> dict[str, tuple[KeyRow, ...]]:
        return {}

    def rows_of(self, text: str) -> tuple[KeyRow, ...]:
        """Return the rows that a symbol may refer to: as written, else with looser letters if only one symbol fits.

        If symbols differ only by their marks, such as the segment pb and p_b, the one with the same marks is chosen.
        """
        written, text = _BRACES.sub("", text), bare(text)
        if text not in self._known:
            self._known[text] = self._rows_of(text)
        rows = self._known[text]
        if len(rows) > 1:
            alike = tuple(row for row in rows if _BRACES.sub("", symbol_text(row, self.key)) == written)
            return alike or rows
        return rows

    def _rows_of(self, text: str) -> tuple[KeyRow, ...]:
        if text in self.every:
            return self.every[text]
        if text in self._round:
            return self._round[text]
        stem = text.rstrip("′")
        if rows := self.every.get(stem[:1] + text[len(stem) :] + stem[1:]):
            # A prime may be above the index or after it.
            return rows
        for spelled, letter in _SPELLED.items():
            if text.startswith(spelled) and (rows := self.every.get(letter + text.removeprefix(spelled))):
                return rows
        # A single letter must match exactly: r of a machine's structure is not R.
        for loose, known in zip(_LOOSER, self._loose if len(text) > 1 else (), strict=False):
            if fitting := known.get(loose(text)):
                return self.every[fitting[0]] if len(fitting) == 1 else ()
        return ()

    @cached_property
    def _loose(self) -> tuple[dict[str, list[str]], ...]:
        """The symbols by their looser letters, for each of the functions `_LOOSER`."""
        lookups: tuple[dict[str, list[str]], ...] = tuple({} for _ in _LOOSER)
        for loose, known in zip(_LOOSER, lookups, strict=True):
            for text in self.every:
                known.setdefault(loose(text), []).append(text)
        return lookups
