"""The screens of the tutorials: the form shows the buttons, fields and messages that a page promises at each step."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path
from types import ModuleType

import matplotlib
import pymupdf
import pytest
from matplotlib import pyplot

from reportgen import catalogue
from tests.documents import PAGES, ROOT, agrees, cells, text_of
from tests.lanes import proof
from tests.page.browser import opened

_BOLD = re.compile(r"\*\*([^*]+)\*\*")
_PICTURE = re.compile(r"\]\(\.\./pictures/([\w-]+)\.png\)")


def screens() -> ModuleType:
    """Return the module `docs/screens.py`, which takes the steps."""
    spec = importlib.util.spec_from_file_location("screens", ROOT / "docs" / "screens.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("page", [page for page in PAGES if page.startswith("docs/tutorials/")])
def test_every_picture_of_a_tutorial_is_drawn_by_a_script(page: str) -> None:
    scripts = text_of("docs/pictures.py") + text_of("docs/screens.py")
    drawn = {name for name in _PICTURE.findall(text_of(page)) if f'"{name.removesuffix("-vi")}' in scripts}
    assert set(_PICTURE.findall(text_of(page))) == drawn


@proof
def test_the_first_report_is_made_in_the_form_as_described(tmp_path: Path) -> None:
    steps, text = screens(), text_of("docs/tutorials/first-report.md")
    pictures: dict[str, bytes] = {}
    with opened() as browser:
        screen = steps.Screen(browser.driver)
        report = pymupdf.open(steps.first_report(screen, tmp_path, pictures.__setitem__))
    assert set(_BOLD.findall(text)) <= screen.used
    assert [*pictures, "first-report-page"] == _PICTURE.findall(text)
    assert f"your report of {report.page_count} pages" in " ".join(text.split())
    (page,) = (page for page in report if page.search_for(". Velocity plan at"))
    assert page.search_for("0.02")
    assert report[0].search_for("Lan Pham")


def test_the_vietnamese_first_report_names_the_words_of_the_form() -> None:
    """Its screens are those of the English page; the words of buttons are in the templates."""
    labels = screens().LABELS["vi"]
    assert set(_BOLD.findall(text_of("docs/tutorials/first-report.vi.md"))) <= {*labels.values(), "PDF"}
    words = text_of("templates/vi/words.yaml")
    for name in ("which machine", "moving", "play", "pause", "not right", "saved", "ready"):
        assert re.search(rf"\b{re.escape(labels[name])}", words), name


@pytest.mark.parametrize("page", ["notebook-study.md", "notebook-study.vi.md"])
def test_the_cells_of_the_notebook_print_what_the_page_shows(page: str, tmp_path: Path) -> None:
    """The formula of the last step agrees with the study; both figures are saved."""
    matplotlib.use("agg")
    sample = catalogue.sample("slider-crank", "en")
    (tmp_path / "slider-crank.yaml").write_text(sample, encoding="utf-8")
    done = cells(f"docs/tutorials/{page}", tmp_path)
    assert [cell.printed for cell in done if not (cell.shown == cell.printed or agrees(cell.shown, cell.printed))] == []
    assert [cell.value is not None for cell in done].count(True) == 1
    assert sum(map(bool, (cell.shown for cell in done))) == 5
    for name in ("rods.pdf", "velocity-plan.pdf"):
        assert (tmp_path / name).read_bytes().startswith(b"%PDF")
    pyplot.close("all")
