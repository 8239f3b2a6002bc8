"""Every quantity of an exercise's key has a name in words, and none of those that belong to machines."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from reportgen import api
from reportgen.case.quantity_wording import phrase
from reportgen.exercise.case import ExerciseCase
from reportgen.formula import vocabulary
from reportgen.formula.vocabulary import KeyChapter

FOLDER = Path(__file__).parents[2] / "assignments" / "plane-motion"
OF_MACHINES = ("centre of percussion", "tâm va đập", "khâu", "link ")


@pytest.mark.parametrize("language", ["vi", "en"])
@pytest.mark.parametrize("path", sorted(FOLDER.glob("*.yaml")), ids=lambda path: path.stem)
def test_every_quantity_has_a_name(path: Path, language: Any) -> None:
    case = ExerciseCase(api.load(path, language))
    shown = [id for id, one in case.ledger.families.items() if not (one.hidden or one.is_plane)]
    names = {id: phrase(id, case.ledger, case.words) for id in shown}
    assert all(names.values()), names
    assert not any(word in name for name in names.values() for word in OF_MACHINES), names


@pytest.mark.parametrize(
    ("id", "chapter"),
    [("v.M.x", KeyChapter.velocity), ("v.A.r", KeyChapter.velocity), ("a.M.y", KeyChapter.acceleration)],
)
def test_components_stand_with_their_vectors(id: str, chapter: KeyChapter) -> None:
    assert vocabulary.row(id).chapter is chapter
