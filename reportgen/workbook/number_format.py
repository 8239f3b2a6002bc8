"""Display text of numbers that are codes in a spreadsheet: 125040 in the format `00000000` is 00125040."""

from __future__ import annotations

import re
from collections.abc import Iterator

from reportgen.workbook.zip_package import number_text

LARGEST = 1e15
"""Number from which a spreadsheet does not keep every digit."""
_TOKEN = re.compile(r'"([^"]*)"|\\(.)|_(.)|\*.|\[[^\]]*\]|([0#?])|([-+(): $!^&\'~{}<>=])|(.)', re.DOTALL)


def displayed(value: float, number_format: str) -> str:
    """Return a number as a cell displays it if its format makes it a code of digits, else "".

    A code has leading zeros, or signs and words between or before its digits: `00000000`, `000-000`, `"SV"0000`.
    Formats of quantities, with decimals, powers of ten, per cent or groups of thousands, change no number here.
    """
    section = number_format.split(";")[0] if '"' not in number_format else _first_section(number_format)
    tokens = list(_tokens(section))
    places = sum(digit for _, digit in tokens)
    is_code = places and (len(tokens) > places or section.count("0") > 1)
    if not is_code or None in [text for text, _ in tokens] or not value.is_integer() or not 0 <= value < LARGEST:
        return ""
    digits = number_text(value)
    pieces: list[str] = []
    for text, is_digit in reversed(tokens):
        if not is_digit:
            pieces.append(text or "")
            continue
        places -= 1
        # The first place takes all the digits that are left.
        own, digits = (digits, "") if not places else (digits[-1:], digits[:-1])
        pieces.append(own or {"0": "0", "?": " "}.get(text or "", ""))
    return "".join(reversed(pieces)).strip()


def _first_section(number_format: str) -> str:
    """Return the part of a format for numbers that are not negative.

    It ends at the first semicolon outside quotation marks.
    """
    match = re.match(r'(?:"[^"]*"|\\.|[^;"])*', number_format)
    return match[0] if match else ""


def _tokens(section: str) -> Iterator[tuple[str | None, bool]]:
    """Yield the signs of a format, each with True for the place of a digit; None for a sign that marks a quantity."""
    for match in _TOKEN.finditer(section):
        quoted, escaped, blank, place, literal, quantity = match.groups()
        if place:
            yield place, True
        elif quantity:
            yield None, False
        elif (text := quoted or escaped or literal or (" " if blank else "")) != "":
            yield text, False
