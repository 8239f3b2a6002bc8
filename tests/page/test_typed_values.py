"""Values as people type them into the form: what can mean one thing is written so, what can mean two is asked."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from reportgen import catalogue
from reportgen.base.yaml_source import read_text
from reportgen.base.yaml_values import at
from reportgen.page.edit_session import EditSession
from reportgen.page.text_changes import changed_text
from tests.page.browser import Browser
from tests.page.typist import Typist, form_alone, value

KIND = "slider-crank"


@pytest.fixture
def file(tmp_path: Path) -> Path:
    (made := tmp_path / "mine.yaml").write_text(catalogue.sample(KIND, "en"), encoding="utf-8")
    return made


def session(file: Path) -> EditSession:
    return EditSession(lambda: pytest.fail("not opened"), "en", path=file)


@pytest.mark.parametrize(
    ("old", "typed", "new"),
    [
        ("[ 300 mm,   # measured on site\n  -40 mm ]", "305 mm, -40 mm", "[ 305 mm,   # measured on site\n  -40 mm ]"),
        ("[ [0, 1],  # low\n  [2, 3] ]", "[0, 1], [2, 4]", "[ [0, 1],  # low\n  [2, 4] ]"),
        ("\n  - 1  # low\n  - 2  # high", "1, 3", "\n  - 1  # low\n  - 3  # high"),
        ("[ 1,  2 ]", "1, 2", "[ 1,  2 ]"),
        ("[ 1,  2 ]", "1, 2, 3", "[ 1,  2, 3 ]"),
    ],
)
def test_only_the_items_that_differ_are_written(old: str, typed: str, new: str) -> None:
    changed = changed_text(f"a: {old}\nb: 1\n", "set", ("a",), {"value": typed, "list": True})
    assert changed == f"a: {new}\nb: 1\n"


@pytest.mark.parametrize(
    ("key", "typed", "written"),
    [
        ("s", "0,35", "0.35"),
        ("l", "512,5 mm", "512.5 mm"),
        ("G3", "1.234,5 N", "1234.5 N"),
        ("G3", "0,8 KN", "0.8 kN"),
        ("G3", "0.8 KN", "0.8 kN"),
        ("n", "900 RPM", "900 rpm"),
        ("l", "98 MM", "98 mm"),
        ("n", "900 vòng/phút", "900 vòng/phút"),
        ("n", "5 vòng/giây", "5 rps"),
        ("l", "1,600 mm", "1,600 mm"),
        ("l", "512", "512"),
        ("l", "abc", "abc"),
        ("G3", "6 kg", "6 kg"),
    ],
)
def test_a_value_with_one_meaning_is_written_so(file: Path, key: str, typed: str, written: str) -> None:
    before = file.read_text(encoding="utf-8")
    old = at(read_text(before).top, ("parameters", key))
    answer = session(file).edit({"op": "set", "where": ["parameters", key], "value": typed})
    assert answer["written"] == value(file, ("parameters", key)) == written
    # All else stays to the letter.
    start, end = old.span  # type: ignore[union-attr]
    in_file = f'"{written}"' if "," in written else written
    assert file.read_text(encoding="utf-8") == before[:start] + in_file + before[end:]


@pytest.mark.parametrize(("typed", "written"), [("Mpa", "MPa"), ("n/cm2", "N/cm2"), ("Pascal", "Pascal"), ("kg", "kg")])
def test_a_unit_in_other_letters_is_written_as_it_is_spelt(tmp_path: Path, typed: str, written: str) -> None:
    (file := tmp_path / "twin.yaml").write_text(catalogue.sample("engine-twin", "en"), encoding="utf-8")
    answer = session(file).edit({"op": "set", "where": ["indicator", "unit"], "value": typed})
    assert answer["written"] == written


def test_text_keeps_its_commas(file: Path) -> None:
    answer = session(file).edit({"op": "set", "where": ["report", "course"], "value": "Theory 1,5"})
    assert answer["written"] == "Theory 1,5"


def test_a_number_of_two_meanings_is_asked_about(file: Path) -> None:
    form = str(session(file).edit({"op": "set", "where": ["parameters", "l"], "value": "1,600 mm"})["form"])
    assert 'data-remedy="1.6 mm"' in form
    assert 'data-remedy="1600 mm"' in form


def test_one_step_back_leads_to_what_was_there(file: Path) -> None:
    begun, edited = file.read_bytes(), session(file)
    edited.edit({"op": "set", "where": ["parameters", "s"], "value": "0,35", "typing": "a.1"})
    edited.edit({"op": "undo"})
    assert file.read_bytes() == begun


@pytest.mark.parametrize("letters", range(20))
def test_any_number_with_a_comma_is_that_with_a_point(file: Path, letters: int) -> None:
    chance = random.Random(letters)
    whole, part = chance.randrange(1, 999), "".join(chance.choice("123456789") for _ in range(chance.choice([1, 2, 4])))
    answer = session(file).edit({"op": "set", "where": ["parameters", "l"], "value": f"{whole},{part} mm"})
    assert answer["written"] == f"{whole}.{part} mm"


def test_commas_typed_along_are_points_in_the_file(browser: Browser, file: Path) -> None:
    """The next field keeps what is typed in it, and the field that was left shows what the file has."""
    with form_alone(file, lambda: 0.3) as server:
        browser.show(server.address, still=True)
        typist = Typist(browser, 0.02)
        typist.replace("l", "512,5 mm")
        typist.press("Tab")
        typist.to_a_field()
        typist.type("85,5 rpm")
        typist.press("Enter")
        typist.idle()
        assert value(file, ("parameters", "l")) == "512.5 mm"
        assert value(file, ("parameters", "n")) == "85.5 rpm"
        assert browser.run("return document.getElementById('f:parameters.l').value") == "512.5 mm"
