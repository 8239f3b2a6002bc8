"""A language is a folder with a file that says how it writes numbers and units, and what page it has."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen.base import languages
from reportgen.base.errors import TemplateError
from reportgen.base.languages import LanguageSetting, UnitNames, read_setting
from reportgen.base.records import replace
from reportgen.base.template_folders import schools
from reportgen.base.units import read_unit
from reportgen.formula import Symbol
from reportgen.formula.vocabulary import in_language

LEAST = "name: Русский\ncode: ru-RU\ndecimal: ','\n"


def written(tmp_path: Path, text: str) -> LanguageSetting:
    file = tmp_path / "language.yaml"
    file.write_text(text, encoding="utf-8")
    return read_setting(file)


def test_a_folder_with_the_file_is_a_language_and_any_other_a_school() -> None:
    assert languages.languages()[:2] == ("vi", "en")
    assert "frames" not in languages.languages()
    assert not {*schools()} & {*languages.languages()}


def test_the_marks_follow_from_the_decimal_one() -> None:
    assert {one: languages.setting_of(one).decimal for one in ("vi", "en")} == {"vi": ",", "en": "."}
    assert {one: languages.setting_of(one).separator for one in ("vi", "en")} == {"vi": ";", "en": ","}


def test_what_a_file_leaves_out_is_the_usual(tmp_path: Path) -> None:
    setting = written(tmp_path, LEAST)
    assert (setting.latex, setting.block, setting.draft, setting.page.left) == ((), "iso", False, 30.0)
    whole = written(tmp_path, f"{LEAST}latex: [T1, T2A]\ndraft: [cam]\npage: {{right: 15}}\nunits: {{m: м, s: с}}\n")
    assert whole.latex == ("T1", "T2A")
    assert (whole.is_draft("cam"), whole.is_draft("shaper"), whole.is_draft()) == (True, False, False)
    assert whole.page == replace(setting.page, right=15.0)


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("", "1:1"),
        ("name: X\ncode: x\n", "1:1: missing: decimal"),
        (f"{LEAST}colour: red\n", "4:1: colour is no key here"),
        ("name: X\ncode: x\ndecimal: ;\n", "3:10: a point or a comma"),
        (f"{LEAST}page: {{left: wide}}\n", "4:14: a number"),
        (f"{LEAST}page: {{left: 35}}\n", "4:7: figures and tables"),
        (f"{LEAST}latex: T2A\n", "4:8: a list, or none"),
        (f"{LEAST}draft: perhaps\n", "4:8: true, false or a list"),
    ],
)
def test_what_does_not_belong_in_it_is_a_fault_with_its_place(tmp_path: Path, text: str, place: str) -> None:
    with pytest.raises(TemplateError) as caught:
        written(tmp_path, text)
    assert f"language.yaml:{place}" in str(caught.value)


RUSSIAN = UnitNames({"m": "м", "mm": "мм", "s": "с", "N": "Н", "kg": "кг", "cm": "см", "rpm": "об/мин", "rad/s": "с⁻¹"})


@pytest.mark.parametrize(
    ("unit", "shown"),
    [
        ("m/(s²·mm)", "м/(с²·мм)"),
        ("N/cm²", "Н/см²"),
        ("kg·m²", "кг·м²"),
        ("rpm", "об/мин"),
        ("rad/s", "с⁻¹"),
        ("°", "°"),
        ("%", "%"),
    ],
)
def test_units_are_written_by_their_letters(unit: str, shown: str) -> None:
    assert RUSSIAN.get(unit) == shown


def test_units_are_read_in_every_language(monkeypatch: pytest.MonkeyPatch) -> None:
    setting = replace(languages.setting_of("en"), units=dict(RUSSIAN))
    monkeypatch.setattr(languages, "setting_of", lambda language: setting)
    languages.common_unit.cache_clear()
    try:
        assert read_unit("м/с", "m/s") == 1
        assert read_unit("Н/см2", "Pa") == pytest.approx(1e4)
        assert read_unit("об/мин", "rpm") == read_unit("rpm", "rpm")
    finally:
        languages.common_unit.cache_clear()


NAMES = {"cb": "ур", "qt": "и", "Pqt": "F_и", "R##": "F_R", "μv": "μ_V", "^t": "τ"}


@pytest.mark.parametrize(
    ("symbol", "shown"),
    [
        (Symbol("M", "cb"), Symbol("M", "ур")),
        (Symbol("M", "qt2"), Symbol("M", "и2")),
        (Symbol("P", "qt2"), Symbol("F", "и2")),
        (Symbol("h", "Pqt2"), Symbol("h", "Fи2")),
        (Symbol("R", "12", "t"), Symbol("F", "R12", "τ")),
        (Symbol("α", "R12"), Symbol("α", "FR12")),
        (Symbol("R"), Symbol("R")),
        (Symbol("μ", "v"), Symbol("μ", "V")),
        (Symbol("v", "BA"), Symbol("v", "BA")),
        (Symbol("l", "O1A"), Symbol("l", "O1A")),
    ],
)
def test_letters_and_indices_are_those_of_the_language(symbol: Symbol, shown: Symbol) -> None:
    assert in_language(symbol, NAMES) == shown
