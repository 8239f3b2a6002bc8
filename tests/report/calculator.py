"""A school calculator: a line's substitution, as text, is worked out in decimals and held against the printed result.

It knows nothing of the program's expressions.  Texts are in plain notation: a decimal point, `-` for minus, `·`, `/`,
`^`, parentheses, degrees behind their number, `sqrt(…)`, `abs(…)`, `sin 30°`, `cos^(2) 30°`, `arctan2(y; x)`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from decimal import ROUND_HALF_UP, Context, Decimal, localcontext

FIGURES = 40
SHOWN = Context(prec=15)
"""Figures of a function's value: what is exact on a calculator (sin 30°) is so here."""
TIE = Decimal("1e-9")
"""Units of the last digit by which a quotient may miss a five that is rounded up."""
PI = Decimal("3.141592653589793238462643383279502884197")
DEGREE = PI / 180
FUNCTIONS: dict[str, Callable[[float], float]] = {
    "sin": math.sin,
    "cos": math.cos,
    "tan": math.tan,
    "arcsin": math.asin,
    "arccos": math.acos,
    "arctan": math.atan,
}
NUMBER = r"\d+(?:\.\d+)?"
TOKEN = re.compile(rf"\s*({NUMBER}|arcsin|arccos|arctan2?|sin|cos|tan|sqrt|abs|[-+·/^();°π])")
RESULT = re.compile(rf"(?P<number>-?{NUMBER})\s*(?P<unit>(?:°|%|[^\W\d][^=;^]*)?)")


def _shown(value: float) -> Decimal:
    """The value of a function as a calculator shows it."""
    return SHOWN.create_decimal_from_float(value)


@dataclass(frozen=True, slots=True)
class Line:
    """The last two parts of a worked line: its substitution and its result, with what it is called before them."""

    symbol: str
    substitution: str
    result: str

    @property
    def digits(self) -> str:
        """The printed number of the result."""
        found = RESULT.fullmatch(self.result)
        assert found is not None, self
        return found["number"]

    @property
    def recomputed(self) -> Decimal:
        """What the calculator shows, rounded half up to the decimals of the printed result and in its unit."""
        value = worked_out(self.substitution)
        decimals = len(self.digits.partition(".")[2])
        with localcontext(prec=FIGURES):
            shown = value / DEGREE if self.result.endswith("°") else value
            unit = Decimal(1).scaleb(-decimals)
            return (shown + (TIE * unit).copy_sign(shown)).quantize(unit, ROUND_HALF_UP)

    @property
    def holds(self) -> bool:
        """Whether the calculator comes to the printed digits; 360° is 0°."""
        off = self.recomputed - Decimal(self.digits)
        return off % 360 == 0 if self.result.endswith("°") else off == 0

    @property
    def corrupted(self) -> Iterator[Line]:
        """The line with each digit of its result another one."""
        for at in (match.start() for match in re.finditer(r"\d", self.digits)):
            yield replace(self, result=f"{self.result[:at]}{(int(self.result[at]) + 1) % 10}{self.result[at + 1 :]}")

    def __str__(self) -> str:
        return f"{self.symbol} = {self.substitution} = {self.result} ({self.recomputed})"


def misses(lines: Iterable[Line]) -> list[str]:
    """The lines that the calculator does not come to, with what it shows."""
    return [str(line) for line in lines if not line.holds]


def is_calculation(text: str) -> bool:
    """Whether a text is numbers, signs and functions only."""
    try:
        worked_out(text)
    except (SyntaxError, ArithmeticError, ValueError):
        return False
    return True


def worked_out(text: str) -> Decimal:
    """The value of a substitution, angles in radians.  Raises `SyntaxError` for what is none."""
    with localcontext(prec=FIGURES):
        return _Reading(text).whole()


class _Reading:
    """A text read from left to right."""

    def __init__(self, text: str) -> None:
        self.tokens: list[str] = []
        at, end = 0, len(text.rstrip())
        while at < end:
            match = TOKEN.match(text, at)
            if match is None:
                raise SyntaxError(text)
            self.tokens.append(match[1])
            at = match.end()
        self.tokens.reverse()

    def next_is(self, *signs: str) -> bool:
        return bool(self.tokens) and self.tokens[-1] in signs

    def take(self, *expected: str) -> str:
        if not self.tokens or (expected and self.tokens[-1] not in expected):
            raise SyntaxError(f"{expected} expected")
        return self.tokens.pop()

    def whole(self) -> Decimal:
        value = self.sum()
        if self.tokens:
            raise SyntaxError(f"{self.tokens} left")
        return value

    def sum(self) -> Decimal:
        value = self.product()
        while self.next_is("+", "-"):
            value = value + self.product() if self.take() == "+" else value - self.product()
        return value

    def product(self) -> Decimal:
        value = self.signed()
        while self.next_is("·", "/"):
            value = value * self.signed() if self.take() == "·" else value / self.signed()
        return value

    def signed(self) -> Decimal:
        if self.next_is("-"):
            self.take()
            return -self.signed()
        return self.power()

    def power(self) -> Decimal:
        value = self.atom()
        return value ** self.exponent() if self.next_is("^") else value

    def exponent(self) -> Decimal:
        self.take("^")
        return self.atom()

    def atom(self) -> Decimal:
        token = self.take()
        if token == "(":
            value = self.sum()
            self.take(")")
        elif token == "π":
            value = PI
        elif token == "sqrt":
            value = self.atom().sqrt()
        elif token == "abs":
            value = abs(self.atom())
        elif token == "arctan2":
            self.take("(")
            y = self.sum()
            self.take(";")
            value = _shown(math.atan2(y, self.sum()))
            self.take(")")
        elif token in FUNCTIONS:
            exponent = self.exponent() if self.next_is("^") else Decimal(1)
            value = _shown(FUNCTIONS[token](float(self.power()))) ** exponent
        elif token[0].isdigit():
            value = Decimal(token)
        else:
            raise SyntaxError(token)
        if self.next_is("°"):
            self.take()
            value *= DEGREE
        return value
