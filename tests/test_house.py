"""The figures of the package structure, measured on a small package."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests import house

FILES = {
    "little/__init__.py": "",
    "little/base.py": '"""Base."""\n\n# A comment.\nx = 1\n"""What x is."""\n',
    "little/middle/__init__.py": "",
    "little/middle/one.py": "from little import base\nfrom little.middle.two import y\nname = f'v.{base.x}'\n",
    "little/middle/two.py": """
from typing import TYPE_CHECKING
if TYPE_CHECKING:
    import little.middle.one
y = f'{1}.v'
""",
    "little/top.py": """
class A: ...
class _B: ...
def called(first, *rest):
    from little.middle.two import y
    called(1, 2, 3, 4)
    return max(1, 2, 3)
""",
    "little/side.py": "from little.base import x\nclass A: ...\nclass _B: ...\n",
    "templates/en/words.md": "…",
    "ARCHITECTURE.md": "One two three.\n",
}


def built(root: Path, **further: str) -> house.House:
    for name, text in {**FILES, **{f"little/{name}.py": text for name, text in further.items()}}.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text, encoding="utf-8")
    return house.House(root, "little")


def test_rooms_arrows_and_floors(tmp_path: Path) -> None:
    little = built(tmp_path)
    assert house.rooms(little) == ["little", "little.base", "little.middle", "little.side", "little.top"]
    assert house.arrows(little) == [
        "little.middle → little.base",
        "little.side → little.base",
        "little.top → little.middle",
    ]
    assert little.floors == {"little": 1, "little.base": 1, "little.middle": 2, "little.side": 2, "little.top": 3}
    assert house.arrows_back_up(little) == []
    # Modules of one room that import one another are a circle all the same.
    assert house.circles(little) == ["little.middle.one ↔ little.middle.two"]


def test_an_arrow_in_a_circle_of_rooms_runs_back_up(tmp_path: Path) -> None:
    little = built(tmp_path, base="def later():\n    from little import side\n")
    assert sorted(house.arrows_back_up(little)) == ["little.base → little.side", "little.side → little.base"]
    assert little.floors["little.base"] == little.floors["little.side"] == 1
    assert little.floors["little.top"] == 3


def test_what_is_counted_of_the_code(tmp_path: Path) -> None:
    little = built(tmp_path)
    assert house.longest_module(little) == 7
    assert house.words_of_architecture(little) == 3
    assert house.class_names_twice(little) == ["A"]
    assert house.ids_by_f_string(little) == [f"{tmp_path / 'little/middle/one.py'}:3"]


def test_an_alias_of_a_type_that_two_modules_define_counts_even_if_they_agree(tmp_path: Path) -> None:
    side = "Row = tuple[str, int]\nEnd = np.ndarray\nOnce = list[int]\n_Own = list[int]\nT = TypeVar('T')\nTable = {}\n"
    top = "Row = tuple[str, int]\nEnd = A | B\n_Own = list[int]\nT = TypeVar('T')\nTable = {}\nPI = x[0]\n"
    little = built(tmp_path, side=side, top=top, base="PI = x[1]\n")
    assert house.type_aliases_twice(little) == ["End", "Row"]
    assert house.type_aliases_twice(built(tmp_path, top="")) == []


def test_a_list_of_any_length_is_one_argument(tmp_path: Path) -> None:
    assert house.longest_positional_call(built(tmp_path)) == 3
    assert house.longest_positional_call(built(tmp_path, side="print(1, 2, 3, 4)\n")) == 4


VAGUE = """
def way(one, *other):
    found = [one for one in other]
    match found:
        case [told]:
            return lambda other: other
    return [
        one
        for one in
        found
    ]
class Told:
    one: int = 1
    def __add__(self, other):
        self.way = other
        return other
"""


def test_a_vague_name_counts_where_it_is_bound_and_lives_longer_than_a_line(tmp_path: Path) -> None:
    counted = house.vague_names(built(tmp_path, side=VAGUE))
    assert isinstance(counted, list)
    assert [place.rsplit(":", 1)[1] for place in counted] == [
        *("2 way", "2 one", "2 other", "3 found", "5 told", "9 one", "13 one", "15 way")
    ]


@pytest.mark.proof
def test_every_vague_name_that_is_allowed_exists(monkeypatch: pytest.MonkeyPatch) -> None:
    allowed = {(module, name) for module, names in house.PUBLIC.items() for name in names}
    monkeypatch.setattr(house, "PUBLIC", {})
    counted = house.vague_names(house.House(house.ROOT))
    assert isinstance(counted, list)
    places = [place.rsplit(":", 1) for place in counted]
    bound = {
        (Path(path).relative_to(house.ROOT).with_suffix("").as_posix().replace("/", "."), rest.split()[1])
        for path, rest in places
    }
    assert bound == allowed


@pytest.mark.proof
def test_a_limit_that_is_passed_is_a_fault(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(house, "LIMITS", {house.circles: 0, house.rooms: 1000})
    assert house.main() == 0
    monkeypatch.setattr(house, "LIMITS", {house.rooms: None})
    assert house.main() == 0
    monkeypatch.setattr(house, "LIMITS", {house.floors: 1})
    assert house.main() == 1
    assert capsys.readouterr().out.count("at most") == 3
