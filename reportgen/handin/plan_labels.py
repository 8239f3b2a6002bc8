"""Labels beside plans: the position of a plan, the letters of its corners, the names of its vectors.

Labels are optional; they support a plan that its shape leaves in doubt.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping, Sequence
from functools import cached_property

import numpy as np

from reportgen.base.records import Record
from reportgen.handin.dxf_lines import DrawnText
from reportgen.handin.plan_fit import Fit
from reportgen.handin.plan_shapes import PlanShape

LETTER = float(np.log(20.0))
"""Evidence of a letter at its place: it is one of twenty possible letters."""
TITLE = float(np.log(1e5))
"""Evidence of a position written beside a plan."""
BESIDE = 3.0
"""Largest distance, in heights of its letters, between a text and what it names."""
ROOM = 30.0
"""Largest distance (mm) of the position's label from its plan."""

_DROPPED = re.compile(r"[\s_^{}()′'’`,.\-]")
_SAME = str.maketrans({"τ": "t", "đ": "d", "Đ": "D"})


def plain(text: str) -> str:
    """Return a text without accents, primes and marks of indices or exponents."""
    letters = unicodedata.normalize("NFKD", text.translate(_SAME))
    return _DROPPED.sub("", "".join(one for one in letters if not unicodedata.combining(one)))


def spoken(text: str) -> str:
    """Return a text in lower case without accents."""
    letters = unicodedata.normalize("NFKD", text.translate(_SAME)).casefold()
    return "".join(one for one in letters if not unicodedata.combining(one))


class Labels(Record, dict=True):
    """The texts of a drawing, in mm; `words` are words for “position”, and `labels` gives the positions by label."""

    texts: tuple[DrawnText, ...]
    words: frozenset[str] = frozenset()
    labels: Mapping[str, int] | None = None

    @cached_property
    def places(self) -> np.ndarray:
        """The middle of each text [T] (complex, mm); the width of a letter is about two thirds of its height."""
        return np.array([one.at + one.height * complex(len(one.text) / 3, 0.5) for one in self.texts], dtype=complex)

    @cached_property
    def heights(self) -> np.ndarray:
        """The height of the letters of each text [T] (mm)."""
        return np.array([one.height for one in self.texts])

    @cached_property
    def by_text(self) -> Mapping[str, np.ndarray]:
        """The numbers [K] of the texts with the same `plain` content, by that content."""
        said: dict[str, list[int]] = {}
        for number, text in enumerate(self.texts):
            said.setdefault(plain(text.text), []).append(number)
        return {text: np.array(numbers) for text, numbers in said.items()}

    @cached_property
    def titles(self) -> list[tuple[int, int]]:
        """The positions that texts name, each with the number of its text."""
        titles = []
        for number, text in enumerate(self.texts):
            said = spoken(text.text)
            named = {
                match[1]
                for word in self.words
                for match in re.finditer(rf"{re.escape(word)}\s*[:=]?\s*(\w+[′']?)", said)
            }
            known = {position for name in named if (position := (self.labels or {}).get(name.replace("'", "′")))}
            if len(known) == 1:
                titles.append((known.pop(), number))
        return titles

    def beside(self, names: Sequence[str], start: complex, end: complex) -> bool:
        """Return True if one of some names is written beside the line from `start` to `end` (mm), or beside a point.

        A point is a line with equal ends. The distance of the text's middle may be `BESIDE` times the height of its
        letters.
        """
        for name in names:
            for number in self.by_text.get(name, ()):
                along, to = end - start, self.places[number] - start
                share = float(np.clip((to * along.conjugate()).real / (abs(along) ** 2 or 1.0), 0.0, 1.0))
                if abs(to - share * along) <= BESIDE * self.heights[number]:
                    return True
        return False

    def speak_for(self, fit: Fit) -> float:
        """Return the evidence of the letters at corners and vectors for a fit, `LETTER` for each that is labelled.

        It is a logarithm of odds, a pure number; 0 for a drawing without texts.
        """
        if not len(self.texts):
            return 0.0
        shape = fit.shape
        corners = {end for number in fit.present for end in (shape.vectors[number].start, shape.vectors[number].end)}
        places = fit.at(shape.corners)
        count = sum(self.beside(letters_of(shape, corner), places[corner], places[corner]) for corner in corners)
        for number in fit.present:
            vector = shape.vectors[number]
            count += self.beside(names_of(shape, int(number)), places[vector.start], places[vector.end])
        return LETTER * count

    def owned(self, fits: Sequence[Fit], ends: np.ndarray) -> dict[int, set[int]]:
        """Return the positions written beside the lines of each fit, by the index of the fit.

        The lines are `ends` [M, 2] (mm). A title belongs to the nearest fit, and to all fits that share lines with it;
        beyond `ROOM` (mm) it belongs to none.
        """
        boxes = [_box(ends[list(fit.explained)]) for fit in fits]
        owned: dict[int, set[int]] = {}
        for position, number in self.titles:
            distances = [_distance(box, complex(self.places[number])) for box in boxes]
            if not distances or min(distances) > ROOM:
                continue
            nearest = fits[int(np.argmin(distances))]
            for at, fit in enumerate(fits):
                if fit.used & nearest.used:
                    owned.setdefault(at, set()).add(position)
        return owned


def letters_of(shape: PlanShape, corner: int) -> list[str]:
    """Return the possible labels of a corner."""
    return [plain(letter) for letter in shape.letters[corner]]


def names_of(shape: PlanShape, number: int) -> list[str]:
    """Return the possible labels of a vector: its symbol, or the letters of its ends."""
    vector = shape.vectors[number]
    starts, ends = letters_of(shape, vector.start), letters_of(shape, vector.end)
    return [*(plain(name) for name in vector.names), *(a + b for a in starts for b in ends)]


def _box(ends: np.ndarray) -> tuple[complex, complex]:
    """Return the lower left and the upper right corner of the box around some points (mm)."""
    return complex(ends.real.min(), ends.imag.min()), complex(ends.real.max(), ends.imag.max())


def _distance(box: tuple[complex, complex], place: complex) -> float:
    """Return the distance (mm) of a place from a box, 0 inside."""
    low, high = box
    x = max(low.real - place.real, 0.0, place.real - high.real)
    y = max(low.imag - place.imag, 0.0, place.imag - high.imag)
    return float(np.hypot(x, y))
