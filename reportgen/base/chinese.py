"""Text conventions of files from China: GBK without a byte-order mark, full-width letters, blanks inside names.

Excel and WPS save CSV files in GBK there, and tables separate the two letters of a name by a blank to align
columns.
"""

from __future__ import annotations

import re

CODEC = "gb18030"
"""Encoding that contains all characters of GBK and of GB 2312."""
COMMON = 0.8
"""Smallest share of common letters among the Han letters of a GBK text; random bytes reach about a third."""
EXPECTED = frozenset("学号姓名班级代符数值单位的机理")
"""Characters one of which occurs in every roster, sheet and assignment file: number, name, class, symbol,
value, unit.
"""
_HAN = "\u3400-\u4dbf\u4e00-\u9fff"
# Patterns are texts, which `re` compiles at their first use: sets of so many letters take it long.
_LETTERS = f"[{_HAN}]"
_BETWEEN = f"(?<=[{_HAN}])[ \u3000]+(?=[{_HAN}])"
_WIDE = {wide: wide - 0xFEE0 for wide in range(0xFF01, 0xFF5F)} | {0x3000: 0x20}


def is_gbk(data: bytes) -> bool:
    """Return True if bytes that are not UTF-8 are Chinese in GBK.

    Texts in other old encodings decode to unlikely Han letters. Small letters with accents and Cyrillic give
    letters above the common ones, which GB 2312 put first; Korean letters give no expected heading.
    """
    try:
        text = data.decode(CODEC)
        re.sub(_LETTERS, "", text).encode("gbk")
    except UnicodeError:
        return False
    letters = [letter.encode(CODEC) for letter in re.findall(_LETTERS, text)]
    return not EXPECTED.isdisjoint(text) and sum(map(_is_common, letters)) >= COMMON * len(letters)


def _is_common(letter: bytes) -> bool:
    """Return True if a letter in GBK is on the first level of GB 2312, which contains the 3755 common ones."""
    return 0xB0 <= letter[0] <= 0xD7 and len(letter) == 2 and letter[1] >= 0xA1


def joined(text: str) -> str:
    """Return a text without the blanks between Chinese letters, which are only for alignment."""
    return re.sub(_BETWEEN, "", text)


def full_name(*parts: str) -> str:
    """Return the parts of a name in their order, with a blank between them unless both are Chinese."""
    return joined(" ".join(parts))


def narrow(text: str) -> str:
    """Return a text with full-width digits, letters and signs replaced by those of a keyboard: －０．５ as -0.5."""
    return text.translate(_WIDE)
