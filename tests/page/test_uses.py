"""Where the report uses a value: the lines that name it, and all that follows from them."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen import catalogue
from reportgen.base.yaml_source import read_text
from reportgen.cases import open_case, opener
from reportgen.page.file_watch import edited
from reportgen.page.value_uses import data_of, uses
from tests.lanes import proof
from tests.page.browser import Browser, axe
from tests.page.typist import until

ASK = """
const field = document.getElementById(arguments[0]);
field.focus();
field.closest(".field").querySelector("[data-uses]").click();
"""


@pytest.mark.parametrize(
    ("kind", "expected"),
    [
        # The least crank is found from the stroke by l₁ = aH/(2 l₃), the quick return from the angle θ of the swing.
        ("shaper", {"n": {"ω_1"}, "H": {"l_1", "θ", "v_m1", "v_m2"}, "l4": {"ω_4", "v_E", "a_ED^n", "ε_4"}}),
        # A bearing load needs the speed; the radius gives the correction mass m = U/r.
        ("rotor", {"correction.r": {"m_A", "m_B"}}),
    ],
)
def test_the_lines_with_a_value_are_found(kind: str, expected: dict[str, set[str]], tmp_path: Path) -> None:
    file = tmp_path / f"{kind}.yaml"
    text = catalogue.sample(kind, "en")
    file.write_text(text, encoding="utf-8")
    case, top = open_case(file), read_text(text).top
    assert top is not None
    document = case.document()
    for key, symbols in expected.items():
        found = uses(case, document, data_of(top, ("parameters", *key.split(".")), file))
        assert symbols <= {line["symbol"] for line in found["lines"]}, found
        assert all(line["title"] and line["heading"] for line in found["lines"])
    of_speed = uses(case, document, data_of(top, ("parameters", "n"), file))
    of_nothing = uses(case, document, data_of(top, ("variant",), file))
    assert of_speed["following"] > 1
    assert of_nothing == {"lines": [], "following": 0}


@pytest.mark.parametrize(
    ("kind", "key", "data"),
    [
        ("gear-pair", "z1", "gears.z.1"),
        ("gear-pair", "z2", "gears.z.2"),
        ("cam", "phases.rise", "cam.phase.rise"),
        ("cam", "phases.far", "cam.phase.far"),
    ],
)
def test_a_value_is_used_that_a_hundredth_more_makes_faulty(kind: str, key: str, data: str, tmp_path: Path) -> None:
    """Numbers of teeth are whole, and the phases of a cam make a full turn."""
    top = read_text(catalogue.sample(kind, "en")).top
    assert top is not None
    assert data in data_of(top, ("parameters", *key.split(".")), tmp_path / f"{kind}.yaml")


@proof
def test_a_line_leads_to_its_section_or_page(browser: Browser, tmp_path: Path) -> None:
    file = tmp_path / "shaper.yaml"
    file.write_text(catalogue.sample("shaper", "en"), encoding="utf-8")
    with edited(file, opener(), "en") as server:
        browser.show(server.address, still=True)
        until(lambda: browser.run("return document.querySelector('#report h2')"))
        browser.run(ASK, "f:parameters.H")
        until(lambda: browser.run("return document.querySelectorAll('#uses li button').length > 1"))
        assert browser.run("return document.activeElement.id") == "uses"
        assert browser.violations(axe(), "#form") == []
        top = browser.run("return scrollY")
        browser.run("document.querySelector('#uses li button').click()")
        until(lambda: browser.run("return scrollY") != top)
        browser.run("document.querySelector('#uses .small').click()")
        assert browser.run("return document.activeElement.id") == "f:parameters.H"
        assert browser.messages() == []
