"""Plain text → LaTeX source, so that it appears on the page exactly as typed.

T5 fonts hold the Vietnamese letters, T1 the other Latin ones; symbols and Greek letters come from the
mathematical fonts.  A character that none of them has is refused before TeX runs.
"""

from __future__ import annotations

import re
import unicodedata

from reportgen.errors import TypesetterError

SPECIAL = {
    "\\": r"\textbackslash{}",
    "{": r"\{",
    "}": r"\}",
    "$": r"\$",
    "&": r"\&",
    "#": r"\#",
    "%": r"\%",
    "_": r"\_",
    "^": r"\textasciicircum{}",
    "~": r"\textasciitilde{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
    '"': r"\textquotedbl{}",
    "'": r"\textquotesingle{}",
    "`": r"\textasciigrave{}",
}
"""ASCII marks that TeX would take for commands or for other signs."""

_LIGATURES = re.compile(r"([-,])(?=\1)")
"""Marks that fonts would join into one sign: -- ,,"""

MATHEMATICAL = {
    "α": r"\alpha", "β": r"\beta", "γ": r"\gamma", "δ": r"\delta", "ε": r"\varepsilon", "ζ": r"\zeta",
    "η": r"\eta", "θ": r"\theta", "ι": r"\iota", "κ": r"\kappa", "λ": r"\lambda", "μ": r"\mu",
    "ν": r"\nu", "ξ": r"\xi", "π": r"\pi", "ρ": r"\rho", "σ": r"\sigma", "τ": r"\tau", "υ": r"\upsilon",
    "φ": r"\varphi", "χ": r"\chi", "ψ": r"\psi", "ω": r"\omega", "Γ": r"\Gamma", "Δ": r"\Delta",
    "Θ": r"\Theta", "Λ": r"\Lambda", "Ξ": r"\Xi", "Π": r"\Pi", "Σ": r"\Sigma", "Υ": r"\Upsilon",
    "Φ": r"\Phi", "Ψ": r"\Psi", "Ω": r"\Omega", "ϕ": r"\phi", "ϑ": r"\vartheta", "ϵ": r"\epsilon",
    "ς": r"\varsigma", "∂": r"\partial", "∇": r"\nabla", "∞": r"\infty", "∑": r"\sum", "∏": r"\prod",
    "∫": r"\int", "≤": r"\le", "≥": r"\ge", "≠": r"\mathrel{\reportactual{2260}{\ne}}", "≈": r"\approx",
    "≡": r"\equiv", "∼": r"\sim", "∈": r"\in", "∝": r"\propto", "≪": r"\ll", "≫": r"\gg", "⊥": r"\perp",
    "⟂": r"\perp", "∥": r"\parallel", "∠": r"\reportactual{2220}{\angle}", "△": r"\triangle",
    "∘": r"\circ", "←": r"\leftarrow", "→": r"\rightarrow", "↑": r"\uparrow", "↓": r"\downarrow",
    "↔": r"\leftrightarrow", "↗": r"\nearrow", "↘": r"\searrow", "↙": r"\swarrow", "↖": r"\nwarrow",
    "⇒": r"\Rightarrow", "⇔": r"\Leftrightarrow", "⋅": r"\cdot", "′": r"{}^{\prime}",
    "″": r"{}^{\prime\prime}", "₀": "{}_0", "₁": "{}_1", "₂": "{}_2", "₃": "{}_3", "₄": "{}_4",
    "₅": "{}_5", "₆": "{}_6", "₇": "{}_7", "₈": "{}_8", "₉": "{}_9", "⁻": "{}^{-}", "⁴": "{}^4",
    "ⁿ": "{}^n", "ȧ": r"\reportactual{0227}{\dot{a}}", "Ȧ": r"\reportactual{0226}{\dot{A}}",
    "ḃ": r"\reportactual{1E03}{\dot{b}}", "Ḃ": r"\reportactual{1E02}{\dot{B}}",
}
"""Characters that the frame declares as this mathematics, in text and in formulas alike."""

TEXTUAL = {
    "°": r"\textdegree", "·": r"\reportdot", "×": r"\texttimes", "÷": r"\textdiv",
    "±": r"\textpm", "¹": r"\textonesuperior", "²": r"\texttwosuperior", "³": r"\textthreesuperior",
    "½": r"\textonehalf", "¼": r"\textonequarter", "¾": r"\textthreequarters", "µ": r"\textmu",
    "§": r"\textsection", "¶": r"\textparagraph", "©": r"\textcopyright", "®": r"\textregistered",
    "™": r"\texttrademark", "€": r"\texteuro", "£": r"\textsterling", "¥": r"\textyen",
    "₫": r"\textdong", "•": r"\textbullet", "‰": r"\UseTextSymbol{TS1}{\textperthousand}",
    "№": r"\textnumero", "…": r"\reportellipsis", "\u00a0": "~", "\u2009": r"\,", "\u202f": r"\,",
    "\u2011": "-", "−": r"\textminus",
}
"""Characters that the frame declares as these text commands, in text and in formulas alike."""

_VIETNAMESE = frozenset(
    "ÀÁÂÃÈÉÊÌÍÒÓÔÕÙÚÝàáâãèéêìíòóôõùúýĂăĐđĨĩŨũƠơƯưẠạẢảẤấẦầẨẩẪẫẬậẮắẰằẲẳẴẵẶặẸẹẺẻẼẽẾếỀềỂểỄễỆệỈỉỊịỌọỎỏỐốỒồỔổỖỗỘộ"
    "ỚớỜờỞởỠỡỢợỤụỦủỨứỪừỬửỮữỰựỲỳỴỵỶỷỸỹ–—‘’‚“”„‹›«»"
)
_OTHER_LATIN = frozenset(
    "ÄÅÆÇËÎÏÐÑÖØÛÜÞßäåæçëîïðñöøûüþÿĄąĆćČčĎďĘęĚěĞğİıĹĺĽľŁłŃńŇňŐőŒœŔŕŘřŚśŞşŠšŤťŮůŰűŸŹźŻżŽžȘșȚț¡¿"
)
_DECLARED = frozenset(MATHEMATICAL) | frozenset(TEXTUAL)


def declarations() -> tuple[tuple[str, str], ...]:
    """(code point in hex, definition) of every character that the frame declares."""
    mathematics = ((char, rf"\ensuremath{{{code}}}") for char, code in MATHEMATICAL.items())
    words = ((char, rf"\reporttextual{{{code}}}") for char, code in TEXTUAL.items())
    return tuple((f"{ord(char):04X}", code) for char, code in (*mathematics, *words))


def escape(text: str) -> str:
    """The LaTeX source that prints `text` as typed.

    Raises `TypesetterError` naming the first character that the fonts do not have.
    """
    source = "".join(map(_character, unicodedata.normalize("NFC", text)))
    return _LIGATURES.sub(r"\1{}", source)


def _character(char: str) -> str:
    if char in SPECIAL:
        return SPECIAL[char]
    if char.isspace() and char not in TEXTUAL:
        return " "
    if " " < char <= "~" or char in _DECLARED or char in _VIETNAMESE:
        return char
    if char in _OTHER_LATIN:
        return rf"\reportlatin{{{char}}}"
    raise TypesetterError(
        f"the LaTeX engine has no character {char!r} (U+{ord(char):04X}, "
        f"{unicodedata.name(char, 'without a name')}); use the engine typst, or write it otherwise"
    )


def hexadecimal(text: str) -> str:
    """A text as a PDF string's content in UTF-16, in hexadecimal digits."""
    return "FEFF" + unicodedata.normalize("NFC", text).encode("utf-16-be").hex().upper()
