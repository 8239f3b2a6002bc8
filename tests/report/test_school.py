"""A school's own words: named in the assignment file, put before the common ones."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from reportgen import api
from reportgen.base.errors import AssignmentError, TemplateError
from reportgen.base.template_folders import search_path, templates
from reportgen.base.units import Language
from reportgen.base.words import sections
from reportgen.case import MachineAnalysis
from reportgen.cases import open_case
from reportgen.document import text_of
from reportgen.document.template_rendering import Prose
from reportgen.formula import Symbol
from reportgen.report.context import ReportContext
from reportgen.report.template_names import names
from reportgen.sheets import title_block
from reportgen.writers import latex, pdflatex, typst_math
from tests.lanes import matrix, proof
from tests.report.built import needs_tex

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
    monkeypatch.setattr("reportgen.base.template_folders.templates", lambda: root)
    text = text_of(api.document(api.load(with_school(tmp_path, "my-school"))))
    assert "As our department asks." in text
    assert "Position plan" in text


@pytest.mark.usefixtures("here")
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
    monkeypatch.setattr("reportgen.base.template_folders.templates", lambda: root)
    text = text_of(api.document(api.load(with_school(tmp_path, "my-school"))))
    assert "shows A, O_1 and ω_1 = " in text
    assert "Our machine" in text
    assert "Our speeds" in text


@pytest.mark.usefixtures("here")
def test_a_section_that_no_report_has_is_a_located_fault(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A misspelt name would change nothing, and nobody would know."""
    root = tmp_path / "templates"
    shutil.copytree(templates(), root)
    (root / "my-school").mkdir()
    (root / "my-school" / "en.md").write_text(
        "%% dyads/senses\nOurs.\n\n%% cycle\nOurs.\n\n%% forewords\n# Preface\n", encoding="utf-8"
    )
    monkeypatch.setattr("reportgen.base.template_folders.templates", lambda: root)
    with pytest.raises(TemplateError, match=r"my-school/en\.md:7: no report has a section forewords"):
        api.document(api.load(with_school(tmp_path, "my-school")))


@pytest.mark.parametrize("name", ["nowhere", "vi", "../vi", "frames"])
def test_an_unknown_school_is_a_located_fault(tmp_path: Path, name: str) -> None:
    (problem,) = api.check(with_school(tmp_path, name), "en")
    assert (problem.code, problem.location.line, problem.location.column) == ("no-such-school", 7, 11)


# --- a school's letter


MARGIN = 20 / 25.4 * 72
"""The white to the right of the text, points."""


def lettered(folder: Path, **letter: str) -> Path:
    file = folder / "mine.yaml"
    lines = "".join(f"\n  {key}: {value}" for key, value in letter.items())
    text = (SAMPLE.parent / "slider-crank-01.yaml").read_text(encoding="utf-8")
    file.write_text(text.replace("  language: vi", f"  language: vi{lines}"), encoding="utf-8")
    return file


@pytest.mark.parametrize(("engine", "there"), [("typst", "New Computer Modern"), ("latex", "Times New Roman")])
def test_a_font_that_an_engine_lacks_is_a_located_fault(tmp_path: Path, engine: api.Engine, there: str) -> None:
    file = lettered(tmp_path, font="No Such Font")
    assert api.check(file) == []
    with pytest.raises(AssignmentError) as caught:
        api.build(file, tmp_path / "out", engine)
    (problem,) = caught.value.problems
    assert (problem.code, problem.location.line, problem.location.column) == ("no-such-font", 7, 9)
    assert "No Such Font" in problem.message
    assert there in problem.message


def test_a_size_that_no_school_asks_for_is_a_fault(tmp_path: Path) -> None:
    (problem,) = api.check(lettered(tmp_path, size="40 pt"))
    assert (problem.code, problem.location.line) == ("choice", 7)


@pytest.mark.usefixtures("here")
@proof
def test_tables_and_lines_keep_within_the_page_in_a_broad_font(tmp_path: Path) -> None:
    """A font that comes with typst, a fifth broader than its usual one, a point larger."""
    pymupdf = pytest.importorskip("pymupdf")
    built = api.build(lettered(tmp_path, font="DejaVu Sans Mono", size="13 pt"), tmp_path / "out", keep_source=True)
    with pymupdf.open(built) as document:
        spans = [
            span
            for page in document
            for block in page.get_text("dict")["blocks"]
            for line in block.get("lines", ())
            for span in line["spans"]
        ]
        beyond = [
            word[4]
            for page in document
            for word in page.get_text("words")
            if page.rect.width < page.rect.height and word[2] > page.rect.width - MARGIN + 1
        ]
    assert sum("DejaVuSansMono" in span["font"] for span in spans) > len(spans) / 3
    assert any(span["size"] == pytest.approx(13, abs=0.01) for span in spans)
    assert beyond == []


def test_a_letter_changes_no_word(tmp_path: Path) -> None:
    own, other = api.load(lettered(tmp_path)), api.load(lettered(tmp_path, font="Times New Roman", size="13 pt"))
    assert text_of(api.document(own)) == text_of(api.document(other))


@needs_tex
def test_latex_sets_times_and_nothing_stands_out(tmp_path: Path) -> None:
    pymupdf = pytest.importorskip("pymupdf")
    assignment = api.load(lettered(tmp_path, font="Times New Roman", size="13 pt"))
    done = pdflatex.compile(latex.write(api.document(assignment), api.letter_of(assignment, "latex")))
    assert done.overfull == ()
    with pymupdf.open(stream=done.pdf, filetype="pdf") as document:
        fonts = {font[2:4] for page in document for font in page.get_fonts()}
        assert any("NimbusRoman" in name or "Termes" in name for _, name in fonts)
        # Letters of dots are made by Metafont on this machine, which another one has not.
        assert "Type3" not in {type for type, _ in fonts}
        assert "Thuyết minh" in document[3].get_text()


CRANK = Path(__file__).parents[2] / "assignments" / "slider-crank-01.yaml"


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize("language", ["ru", "zh", "vi"])
def test_a_school_may_have_words_in_any_one_language(language: str, tmp_path: Path) -> None:
    (tmp_path / "ours").mkdir()
    words = "%% foreword\n# Our foreword {{ unnumbered() }}\n\nAs our department asks.\n"
    (tmp_path / "ours" / f"{language}.md").write_text(words, encoding="utf-8")
    file = tmp_path / "mine.yaml"
    text = CRANK.read_text(encoding="utf-8")
    file.write_text(text.replace("language: vi", f"language: {language}\n  templates: ours"), encoding="utf-8")
    assert api.check(file) == []
    if language == "ru":
        assert "As our department asks." in text_of(api.document(api.load(file)))


@pytest.fixture(scope="module")
def report() -> ReportContext:
    case = open_case(CRANK, "en")
    assert isinstance(case, MachineAnalysis)
    return ReportContext(case)


@pytest.mark.parametrize("gap", ["{0}", "{}", "{#f}", "{x y}", "{_x}", "{'}"])
def test_a_gap_that_names_nothing_is_a_fault_of_its_line(gap: str, report: ReportContext, tmp_path: Path) -> None:
    """What is no name of a quantity or of a letter becomes no formula, whose source the typesetter would refuse."""
    file = tmp_path / "en.md"
    file.write_text(f'%% foreword\n# Ours\n\n{{{{ say("{gap}", driver) }}}} ends here.\n', encoding="utf-8")
    prose = Prose((file, *search_path("en", "slider-crank")))
    with pytest.raises(TemplateError, match="unknown placeholder"):
        prose.render("foreword", names(report))


def test_a_symbol_without_letters_is_set_by_every_typesetter() -> None:
    """Marks of a symbol hang on something: in Typst `$_("0")$` would be a mistake of syntax."""
    assert typst_math.TypstFormulas("en").symbol(Symbol("", "0")).startswith('""_')


SAMPLES = [("vi", "Trường Đại học Mẫu"), ("en", "Sample University")]


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize(("language", "ours"), matrix(SAMPLES, SAMPLES[:1]))
def test_the_sample_school_shows_all_that_a_school_changes(language: Language, ours: str) -> None:
    folder = templates() / "sample-school"
    assignment = api.load(folder / "assignment.yaml", language)
    assert (assignment.report.font, assignment.report.size) == ("Times New Roman", "13 pt")
    document = api.document(assignment)
    text = text_of(document)
    assert ours in document.header[0]
    for section in ("foreword", "references"):
        heading = sections(folder / f"{language}.md")[section].text.splitlines()[0].split("{{")[0].strip("# ")
        assert heading in text
    assert title_block.blocks("sample-school")["tcvn"].is_relative_to(folder)
