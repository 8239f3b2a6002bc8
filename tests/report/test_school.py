"""A school's own words: named in the assignment file, put before the common ones."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from reportgen import api
from reportgen.base.errors import TemplateError
from reportgen.base.words import templates
from reportgen.report import text_of
from tests.lanes import proof

SAMPLE = Path(__file__).parents[2] / "assignments" / "engine-twin-05.yaml"


def with_school(folder: Path, name: str) -> Path:
    file = folder / "mine.yaml"
    text = SAMPLE.read_text(encoding="utf-8").replace("  language: vi", f"  language: en\n  school: {name}")
    file.write_text(text, encoding="utf-8")
    return file


def test_a_school_overrides_one_section(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    root = tmp_path / "templates"
    shutil.copytree(templates(), root)
    (root / "my-school").mkdir()
    (root / "my-school" / "en.md").write_text(
        "%% foreword\n# Preface {{ unnumbered() }}\n\nAs our department asks.\n", encoding="utf-8"
    )
    monkeypatch.setattr("reportgen.base.words.templates", lambda: root)
    text = text_of(api.document(api.load(with_school(tmp_path, "my-school"))))
    assert "As our department asks." in text
    assert "Position plan" in text


@proof
def test_a_section_of_a_school_may_call_and_write_short(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    root = tmp_path / "templates"
    shutil.copytree(templates(), root)
    (root / "my-school").mkdir()
    (root / "my-school" / "en.md").write_text(
        "%% foreword\n# Preface {{ unnumbered() }}\n\n"
        "Fig. @fig.ours shows $A$, $O_1$ and $omega.1$ = {{ value('omega.1') }}.\n\n"
        '{{ figure("scheme", "fig.ours", "Our machine") }}\n\n'
        '{{ tables("tab.ours", "Our speeds", ["v.B"], positions) }}\n',
        encoding="utf-8",
    )
    monkeypatch.setattr("reportgen.base.words.templates", lambda: root)
    text = text_of(api.document(api.load(with_school(tmp_path, "my-school"))))
    assert "shows A, O_1 and ω_1 = " in text
    assert "Our machine" in text
    assert "Our speeds" in text


def test_a_section_that_no_report_has_is_a_located_fault(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A misspelt name would change nothing, and nobody would know."""
    root = tmp_path / "templates"
    shutil.copytree(templates(), root)
    (root / "my-school").mkdir()
    (root / "my-school" / "en.md").write_text(
        "%% dyads/senses\nOurs.\n\n%% cycle\nOurs.\n\n%% forewords\n# Preface\n", encoding="utf-8"
    )
    monkeypatch.setattr("reportgen.base.words.templates", lambda: root)
    with pytest.raises(TemplateError, match=r"my-school/en\.md:7: no report has a section forewords"):
        api.document(api.load(with_school(tmp_path, "my-school")))


@pytest.mark.parametrize("name", ["nowhere", "vi", "../vi", "frames"])
def test_an_unknown_school_is_a_located_fault(tmp_path: Path, name: str) -> None:
    (problem,) = api.check(with_school(tmp_path, name), "en")
    assert (problem.code, problem.mark.line, problem.mark.column) == ("no-such-school", 7, 11)
