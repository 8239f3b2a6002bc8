"""A school's templates are what others wrote: they run in a sandbox, in a process that can be ended."""

from __future__ import annotations

import shutil
import time
from collections.abc import Callable
from itertools import product
from pathlib import Path

import pytest

from reportgen import api
from reportgen.base.errors import TemplateError
from reportgen.base.limits import Limits
from reportgen.base.units import Language
from reportgen.base.words import templates
from reportgen.report import text_of
from tests.lanes import matrix, proof

ASSIGNMENTS = Path(__file__).parents[2] / "assignments"
SAMPLE = ASSIGNMENTS / "slider-crank-01.yaml"
EXERCISE = ASSIGNMENTS / "plane-motion" / "01.yaml"
UNSAFE = {"en": "may not use", "vi": "không được phép"}
GREEDY = {"en": r"may take \d+ s and 500 MB", "vi": r"chỉ được dùng \d+ s và 500 MB"}

School = Callable[..., Path]


@pytest.fixture
def school(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> School:
    """Makes an assignment of a school whose file in a language has this text."""
    root = tmp_path / "templates"
    shutil.copytree(templates(), root)
    (root / "ours").mkdir()
    monkeypatch.setattr("reportgen.base.words.templates", lambda: root)

    def made(text: str, language: str = "en", sample: Path = SAMPLE) -> Path:
        (root / "ours" / f"{language}.md").write_text(text, encoding="utf-8")
        lines = [line for line in sample.read_text(encoding="utf-8").splitlines() if not line.startswith("  language:")]
        if "report:" not in lines:
            lines.append("report:")
        at = lines.index("report:") + 1
        file = tmp_path / "mine.yaml"
        text = "\n".join([*lines[:at], f"  language: {language}", "  school: ours", *lines[at:], ""])
        file.write_text(text, encoding="utf-8")
        return file

    return made


ESCAPES = (
    "cycler.__init__.__globals__.os.getcwd()",
    "''.__class__.__mro__",
    "'{0.__class__}'.format(machine)",
    "words.update(a=1)",
    "figure.args[0].prose.places[0].unlink()",
    "figure.func",
    "lipsum.__globals__",
    "machine|attr('__class__')",
    "[machine]|map(attribute='__class__')|list",
)


@pytest.mark.parametrize("language", matrix(["en", "vi"], ["vi"]))
@pytest.mark.parametrize("escape", matrix(ESCAPES, ESCAPES[::4]))
def test_what_reaches_out_of_a_template_is_a_located_fault(school: School, escape: str, language: str) -> None:
    file = school(f"%% foreword\n# A {{{{ unnumbered() }}}}\n\nB {{{{ {escape} }}}}\n", language)
    with pytest.raises(TemplateError, match=rf"ours/{language}\.md:4: .*{UNSAFE[language]}"):
        api.document(api.load(file))


def test_an_array_of_the_report_cannot_write_itself(school: School, tmp_path: Path) -> None:
    target = tmp_path / "written"
    file = school(f'%% foreword\n# A {{{{ unnumbered() }}}}\n\n{{{{ machine.cycle_angles.tofile("{target}") }}}}\n')
    with pytest.raises(TemplateError, match=r"ours/en\.md:4: "):
        api.document(api.load(file))
    assert not target.exists()


GREED = {
    "loops": "{% for i in range(99999) %}{% for j in range(99999) %}{% endfor %}{% endfor %}",
    "memory": "{{ 'x' * 10 ** 10 }}",
    "power": "{{ 9 ** (9 ** 9) }}",
}


@pytest.mark.parametrize(("greed", "language"), matrix(product(("loops", "memory"), ("en", "vi")), [("memory", "en")]))
def test_a_greedy_template_is_ended_and_located(
    school: School, greed: str, language: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("reportgen.base.limits.TEMPLATES", Limits(3, 500))
    file = school(f"%% foreword\n# A {{{{ unnumbered() }}}}\n\n{GREED[greed]}\n", language)
    # Ended from outside, as on a machine that is busy, it tells the file alone.
    with pytest.raises(TemplateError, match=rf"ours/{language}\.md:[14]: .*{GREEDY[language]}"):
        api.document(api.load(file))


@pytest.mark.proof
@pytest.mark.parametrize("greed", GREED)
def test_no_template_takes_longer_than_its_limit(school: School, greed: str) -> None:
    """Not even in a single operation, which nothing inside the process interrupts."""
    file = school(f"%% foreword\n# A {{{{ unnumbered() }}}}\n\n{GREED[greed]}\n")
    start = time.monotonic()
    with pytest.raises(TemplateError, match=r"ours/en\.md:\d+: "):
        api.document(api.load(file))
    assert time.monotonic() - start < 40


@proof
def test_a_task_and_an_exercise_are_bounded_too(school: School) -> None:
    case = api.open_case(school("%% task\n{{ ''.__class__ }}\n"))
    with pytest.raises(TemplateError, match=r"ours/en\.md:2: .*may not use"):
        case.task(case.key())
    case = api.open_case(school("%% exercise-task\n{{ ''.__class__ }}\n", sample=EXERCISE))
    with pytest.raises(TemplateError, match=r"ours/en\.md:2: .*may not use"):
        case.task(case.key())


@pytest.mark.parametrize("path", sorted(ASSIGNMENTS.glob("*.yaml")), ids=lambda path: path.stem)
@pytest.mark.proof
def test_the_sandbox_changes_no_report(school: School, path: Path) -> None:
    """All that the common words use is allowed, and fits within the limits."""
    file = school("A note, and no section.\n", sample=path)
    plain = file.with_name("plain.yaml")
    plain.write_text(file.read_text(encoding="utf-8").replace("  school: ours\n", ""), encoding="utf-8")
    assert text_of(api.document(api.load(file))) == text_of(api.document(api.load(plain)))


@pytest.mark.parametrize(("language", "told"), [("en", "leads out of the folder"), ("vi", "dẫn ra ngoài thư mục")])
@pytest.mark.parametrize("link", ["ours", "ours/en.md", "ours/blocks"])
def test_a_link_out_of_the_folder_of_a_school_is_refused(
    school: School, tmp_path: Path, link: str, language: Language, told: str
) -> None:
    file = school("%% foreword\n# Ours\n")
    target = tmp_path / "templates" / link
    elsewhere = tmp_path / "elsewhere"
    if target.exists():
        target.rename(elsewhere)
    else:
        elsewhere.mkdir()
    target.symlink_to(elsewhere)
    (problem,) = api.check(file, language)
    line = file.read_text(encoding="utf-8").splitlines().index("  school: ours") + 1
    assert (problem.code, problem.mark.line, problem.mark.column) == ("path-outside", line, 11)
    assert told in str(problem)


GAPS = ("{g.__init__.__globals__}", "{k.__class__}", "{words[cover]}", "{k:>99999999}", "{k:{g}}", "{_k}", "{")


@pytest.mark.parametrize("language", matrix(["en", "vi"], ["en"]))
@pytest.mark.parametrize("gap", matrix(GAPS, GAPS[::3]))
def test_a_gap_of_a_schools_words_names_a_value(school: School, gap: str, language: Language) -> None:
    file = school(f'A note.\n\n%% words\ncaptions:\n  scheme: "Ours {gap}"\n', language)
    with pytest.raises(TemplateError, match=rf"ours/{language}\.md:5:11: .*{UNSAFE[language]}"):
        api.document(api.load(file))


FILLED = {"en": "nothing fills a gap of", "vi": "không có gì để điền"}
UNFILLED = (
    'header: "{nobody}"',
    'variant: "{variant.nothing}"',
    'cover: {no_date: "{}"}',
    'captions: {scheme: "{nobody}"}',
)


@pytest.mark.parametrize("language", matrix(["en", "vi"], ["vi"]))
@pytest.mark.parametrize("words", matrix(UNFILLED, UNFILLED[:1]))
def test_a_gap_that_nothing_fills_is_a_located_fault(school: School, words: str, language: Language) -> None:
    """Whoever uses the word: a template, or what stands on every page."""
    file = school(f"A note.\n\n%% words\n{words}\n", language)
    column = words.index('"') + 1
    with pytest.raises(TemplateError, match=rf"ours/{language}\.md:4:{column}: {FILLED[language]}"):
        _pages(file)


def _pages(file: Path) -> None:
    """All that is made with the words of a school."""
    case = api.open_case(file)
    case.document()
    case.task(case.key())
    case.sheets()


FORMED = {"en": "another form", "vi": "không cùng dạng"}


@pytest.mark.parametrize("language", matrix(["en", "vi"], ["vi"]))
@pytest.mark.parametrize(
    ("words", "line", "path"),
    [
        ("units: 5", 4, "units"),
        ("cover: [a]", 4, "cover"),
        ("cover:\n  title:", 5, "cover.title"),
        ("cover:\n  title: {a: b}", 5, "cover.title"),
        ("strokes: [One, Two]", 4, "strokes"),
        ("vector:\n  rows: [[One], Two, Three]", 5, "vector.rows"),
    ],
)
def test_a_word_of_another_form_is_a_located_fault(
    school: School, words: str, line: int, path: str, language: Language
) -> None:
    file = school(f"A note.\n\n%% words\n{words}\n", language)
    with pytest.raises(TemplateError, match=rf"ours/{language}\.md:{line}: “{path}” .*{FORMED[language]}"):
        _pages(file)
