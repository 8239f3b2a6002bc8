"""What files from China have of their own: bytes of GBK without a mark, letters as wide as Han, blanks in names.

Excel and WPS save a CSV there in GBK, and tables part the two letters of a name by a blank to make columns even.
"""

from __future__ import annotations

import re

CODEC = "gb18030"
"""It has all letters of GBK, and of GB 2312 before it."""
COMMON = 0.8
"""Of a text that is GBK so many of its Han letters are among the common ones; chance puts a third there."""
EXPECTED = frozenset("学号姓名班级代符数值单位的机理")
"""One of these stands in any roster, sheet and assignment file: in number, name, class, symbol, value, unit."""
_HAN = "\u3400-\u4dbf\u4e00-\u9fff"
_LETTERS = re.compile(f"[{_HAN}]")
_BETWEEN = re.compile(f"(?<=[{_HAN}])[ \u3000]+(?=[{_HAN}])")
_WIDE = {wide: wide - 0xFEE0 for wide in range(0xFF01, 0xFF5F)} | {0x3000: 0x20}


def is_gbk(data: bytes) -> bool:
    """Whether bytes that are no UTF-8 are Chinese in GBK.

    Letters of other old encodings make Han of a kind that no text is full of: those of small letters with accents, or
    of Cyrillic, come from above the common ones, which GB 2312 put first; those of Korean make no heading.
    """
    try:
        text = data.decode(CODEC)
        _LETTERS.sub("", text).encode("gbk")
    except UnicodeError:
        return False
    letters = [letter.encode(CODEC) for letter in _LETTERS.findall(text)]
    return not EXPECTED.isdisjoint(text) and sum(map(_is_common, letters)) >= COMMON * len(letters)


def _is_common(letter: bytes) -> bool:
    """Whether a letter in GBK stands on the first level of GB 2312, that of the 3755 common ones."""
    return 0xB0 <= letter[0] <= 0xD7 and len(letter) == 2 and letter[1] >= 0xA1


def joined(text: str) -> str:
    """Return a text without the blanks between letters of Chinese, which stand there for the looks alone."""
    return _BETWEEN.sub("", text)


def full_name(*parts: str) -> str:
    """Return the parts of a name in their order, with a blank between them unless both are Chinese."""
    return joined(" ".join(parts))


def narrow(text: str) -> str:
    """Return a text with digits, letters and marks of the width of Han as those of a keyboard: －０．５ as -0.5."""
    return text.translate(_WIDE)
