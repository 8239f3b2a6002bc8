"""Vocabulary of the friction exercises: the ids `friction.TASK.…` with their symbols, kinds and chapters."""

from __future__ import annotations

from collections.abc import Mapping

from reportgen.formula.ids import Name
from reportgen.formula.vocabulary import KeyChapter, QuantityKind, VocabularyRow

KINDS: Mapping[str, QuantityKind] = {
    "friction length": QuantityKind("mm", 1e-3, decimals=2),
    "friction torque": QuantityKind("N·mm", 1e-3),
    "friction pressure": QuantityKind("N/m²"),
    "angle in radians": QuantityKind("rad", decimals=4),
}


def _rows(task: str, *rows: tuple[str, str, str, str, KeyChapter | None]) -> tuple[VocabularyRow, ...]:
    """Return the vocabulary rows of a task from the end of each id, letter with index, superscript, kind and
    chapter.
    """
    made = []
    for end, symbol, above, kind, chapter in rows:
        letter, _, below = symbol.partition("_")
        made.append(VocabularyRow(Name(f"friction.{task}.{end}"), letter, kind, chapter, below=below, above=above))
    return tuple(made)


_G, _F, _T = KeyChapter.geometry, KeyChapter.forces, KeyChapter.torque
_LENGTH = "friction length"

ROWS: tuple[VocabularyRow, ...] = (
    *_rows(
        "incline",
        ("Q", "Q", "", "force", None),
        ("alpha", "α", "", "angle", None),
        ("f", "f", "", "ratio", None),
        ("beta", "β", "", "angle", _G),
        ("phi", "φ", "", "angle", _G),
        ("mu", "μ_P", "", "force scale", _F),
        ("P", "P", "", "force", _F),
        ("N", "N", "", "force", _F),
        ("F", "F", "", "force", _F),
        ("lowering.P", "P", "′", "force", _F),
        ("lowering.N", "N", "′", "force", _F),
        ("lowering.F", "F", "′", "force", _F),
        ("P0", "P_0", "", "force", _T),
        ("eta", "η", "", "ratio", _T),
    ),
    *_rows(
        "wedge",
        ("Q", "Q", "", "force", None),
        ("alpha", "α", "", "angle", None),
        *((f"f{number}", f"f_{number}", "", "ratio", None) for number in "123"),
        *((f"phi{number}", f"φ_{number}", "", "angle", _G) for number in "123"),
        ("mu", "μ_P", "", "force scale", _F),
        ("P", "P", "", "force", _F),
        *((f"R{number}", f"R_{number}", "", "force", _F) for number in "123"),
        ("lowering.P", "P", "′", "force", _F),
        *((f"lowering.R{number}", f"R_{number}", "′", "force", _F) for number in "123"),
        ("P0", "P_0", "", "force", _T),
        ("eta", "η", "", "ratio", _T),
    ),
    *_rows(
        "screw",
        ("Q", "Q", "", "force", None),
        ("d", "d_2", "", _LENGTH, None),
        ("p", "p", "", _LENGTH, None),
        ("n", "n", "", "count", None),
        ("beta", "β", "", "angle", None),
        ("f", "f", "", "ratio", None),
        ("fc", "f_c", "", "ratio", None),
        ("dc", "d_c", "", _LENGTH, None),
        ("lead", "l", "", _LENGTH, _G),
        ("gamma", "γ", "", "angle", _G),
        ("f.reduced", "f", "′", "ratio", _G),
        ("phi", "φ", "′", "angle", _G),
        ("Mc", "M_c", "", "friction torque", _F),
        ("Mt", "M_t", "", "friction torque", _F),
        ("M", "M", "", "friction torque", _F),
        ("lowering.Mt", "M_t", "′", "friction torque", _F),
        ("lowering.M", "M", "′", "friction torque", _F),
        ("eta", "η", "", "ratio", _T),
    ),
    *_rows(
        "belt",
        ("d", "D", "", "length", None),
        ("theta", "θ", "", "angle", None),
        ("f", "f", "", "ratio", None),
        ("b", "b", "", "length", None),
        ("r", "r", "", "length", _G),
        ("radians", "θ_rad", "", "angle in radians", _G),
        ("k", "k", "", "ratio", _G),
        ("F", "F", "", "force", _F),
        ("S1", "S_1", "", "force", _F),
        ("S2", "S_2", "", "force", _F),
        ("M", "M", "", "torque", _F),
        ("R", "R", "", "force", _F),
        ("p", "p_max", "", "friction pressure", _F),
    ),
    *_rows(
        "band",
        ("M", "M", "", "torque", None),
        ("d", "D", "", "length", None),
        ("theta", "θ", "", "angle", None),
        ("f", "f", "", "ratio", None),
        ("l", "l", "", "length", None),
        ("a", "a", "", "length", None),
        ("b", "b", "", "length", None),
        ("r", "r", "", "length", _G),
        ("radians", "θ_rad", "", "angle in radians", _G),
        ("k", "k", "", "ratio", _G),
        ("F", "F", "", "force", _F),
        ("S1", "S_1", "", "force", _F),
        ("S2", "S_2", "", "force", _F),
        ("P", "P", "", "force", _F),
        ("backward.P", "P", "′", "force", _F),
    ),
    *_rows(
        "shoe",
        ("M", "M", "", "torque", None),
        ("d", "D", "", "length", None),
        ("f", "f", "", "ratio", None),
        ("l", "l", "", "length", None),
        ("a", "a", "", "length", None),
        ("c", "c", "", "length", None),
        ("r", "r", "", "length", _G),
        ("F", "F", "", "force", _F),
        ("N", "N", "", "force", _F),
        ("P", "P", "", "force", _F),
        ("backward.P", "P", "′", "force", _F),
        ("locking", "c_0", "", "length", _F),
    ),
)
