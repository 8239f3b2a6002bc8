"""Symbols of a key as students write them, and the rows that they stand for."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property

from reportgen.case.key import Key, KeyRow
from reportgen.handin.word_text import LETTERS
from reportgen.marking.key import symbol_text

_MARKS = re.compile(r"[\s_^{}|]")
_BRACES = re.compile(r"[\s{}|]")
_POWER = re.compile(r"\^\{?(\d+)\}?")
"""An exponent of v_B^2, which is no v_B2."""
_ROUND = re.compile(r"\(\d\)$")
"""The number behind a quantity that is worked out twice, M_cb^(1)."""
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
"""What stands for a Greek letter on a keyboard without any."""


def bare(text: str) -> str:
    """A symbol without what sets its index or exponent off: v_{BA}, v_BA and vBA are one."""
    return _MARKS.sub("", _POWER.sub(r"↑\1", "".join(LETTERS.get(letter, letter) for letter in text)))


def _latin(text: str) -> str:
    return text.casefold().translate(_LATIN)


_LOOSER: Sequence[Callable[[str], str]] = (str.casefold, _latin)


class Symbols:
    """All symbols of a key, and which of its rows that are asked for each of them is."""

    def __init__(self, key: Key, rows: Iterable[KeyRow]) -> None:
        """`rows` are those of the part of the key that is looked at."""
        self.key = key
        self.rows = tuple(rows)

    @cached_property
    def every(self) -> dict[str, tuple[KeyRow, ...]]:
        """The rows by their symbols, asked for or not."""
        every: dict[str, tuple[KeyRow, ...]] = {}
        for row in self.rows:
            text = bare(symbol_text(row, self.key))
            every[text] = (*every.get(text, ()), row)
        return every

    @cached_property
    def _round(self) -> dict[str, tuple[KeyRow, ...]]:
        """Those that are worked out several times by what their symbols have in common."""
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
        """The rows that a symbol may stand for: as it is written, else by looser letters if only one symbol fits.

        Of symbols that differ by their marks alone, the segment pb and p_b, it is the one with the same marks.
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
            # A prime may stand above the index or behind it.
            return rows
        for spelled, letter in _SPELLED.items():
            if text.startswith(spelled) and (rows := self.every.get(letter + text.removeprefix(spelled))):
                return rows
        # A letter alone is too little: r of a machine's structure is no R.
        for loose, known in zip(_LOOSER, self._loose if len(text) > 1 else (), strict=False):
            if fitting := known.get(loose(text)):
                return self.every[fitting[0]] if len(fitting) == 1 else ()
        return ()

    @cached_property
    def _loose(self) -> tuple[dict[str, list[str]], ...]:
        """The symbols by their looser letters, in each way."""
        ways: tuple[dict[str, list[str]], ...] = tuple({} for _ in _LOOSER)
        for loose, known in zip(_LOOSER, ways, strict=True):
            for text in self.every:
                known.setdefault(loose(text), []).append(text)
        return ways
