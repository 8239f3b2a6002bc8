"""Every kind with a crank bears what every file may say: instants, acceleration, loads, springs, faces, friction."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest
import yaml

from reportgen import api
from reportgen.base.kinds import kinds
from reportgen.cases import opened
from reportgen.catalogue import sample
from reportgen.marking.task_paper import task_of
from reportgen.marking.toleranced_key import key_of
from tests.lanes import matrix

REMARKED = re.compile(r"^  # (?=(at|loads|springs|faces|friction|epsilon1): )", re.MULTILINE)
EVENLY = re.compile(r"^  (count|direction|worked_positions): .*\n", re.MULTILINE)
OWN_LOADS = {"force", "cutting", "torque", "press"}
CRANKS = sorted(name for name in kinds() if "# plane: horizontal" in sample(name, "en"))
File = dict[str, Any]


def everything(file: File) -> File:
    """What a new file only remarks stands in it."""
    return file


def springs_alone(file: File) -> File:
    """No load of the kind's own; what is named as one is a spring's."""
    kept = {key: value for key, value in file["parameters"].items() if key not in OWN_LOADS}
    return file | {"parameters": kept | ({"loads": []} if file["kind"] == "linkage" else {})}


def without_weights(file: File) -> File:
    """Over a whole turn, in a horizontal plane."""
    given: File = {"plane": "horizontal"}
    for key, value in file["parameters"].items():
        given |= {f"m{key[1:]}": value.replace(" N", " kg")} if key[0] == "G" else {key: value}
    if "masses" in given:
        given["masses"] = [{"link": "2", "at": "S2", "m": "3 kg", "J": "0.02 kg m2"}]
    return file | {"parameters": given, "positions": {"count": "6"}}


FORMS: Mapping[str, tuple[Callable[[File], File], str, str]] = {
    "everything": (everything, "vi", "full"),
    "springs-alone": (springs_alone, "en", "short"),
    "without-weights": (without_weights, "en", "full"),
}
"""What is made of a new file, in which language and extent."""
CASES = [(kind, form) for kind in CRANKS for form in FORMS]
TELLING = [("engine-single", "everything"), ("toggle-press", "springs-alone")]


@pytest.mark.parametrize(("kind", "form"), matrix(CASES, TELLING))
def test_every_kind_bears_it(tmp_path: Path, kind: str, form: str) -> None:
    """Report, key and task say it without a fault."""
    new = sample(kind, "en")
    assert {"at", "springs"} <= {found[1] for found in REMARKED.finditer(new)}
    text = EVENLY.sub("", REMARKED.sub("  ", new))
    change, language, extent = FORMS[form]
    told = change(yaml.load(text, yaml.BaseLoader)) | {"report": {"language": language, "extent": extent}}
    path = tmp_path / "told.yaml"
    path.write_text(yaml.safe_dump(told, allow_unicode=True, sort_keys=False), encoding="utf-8")
    case = opened(api.load(path))
    assert api.document(case.assignment).blocks
    assert task_of(case, key_of(case)).blocks
