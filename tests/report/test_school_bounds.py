"""A school's templates are what others wrote: they run in a sandbox, in a process that can be ended."""

from __future__ import annotations

import re
import shutil
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from reportgen import api
from reportgen.base.errors import TemplateError
from reportgen.base.process_limits import PATIENCE, TEMPLATES, Limits
from reportgen.base.template_folders import search_path, templates
from reportgen.base.units import Language
from reportgen.base.words import load_words
from reportgen.document import text_of
from reportgen.marking.task_paper import task_of
from reportgen.marking.toleranced_key import key_of
from reportgen.sheets import drawing_sheets
from tests.lanes import matrix, proof
from tests.report import built

ASSIGNMENTS = Path(__file__).parents[2] / "assignments"
SAMPLE = ASSIGNMENTS / "slider-crank-01.yaml"
EXERCISE = ASSIGNMENTS / "plane-motion" / "01.yaml"
UNSAFE = {"en": "may not use", "vi": "không được phép"}
GREEDY = {"en": r"limits of \d+ s and 500 MB", "vi": r"chỉ được dùng \d+ s và 500 MB"}

School = Callable[..., Path]


@pytest.fixture
def school(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> School:
    """Makes an assignment of a school whose file in a language has this text."""
    root = tmp_path / "templates"
    shutil.copytree(templates(), root)
    (root / "ours").mkdir()
    monkeypatch.setattr("reportgen.base.template_folders.templates", lambda: root)

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


REFUSED = (
    "machine|attr('__class__')",
    "[machine]|map(attribute='__class__')|list",
    "''.__class__.__mro__",
    "machine|string",
    "'%s' % machine",
    "say(*machine)",
    "words.update(_a=1)",
    "self._TemplateReference__context",
    "'x' * 10 ** 10",
    "9 ** (9 ** 9)",
)
MISSING = (
    "'{0.real}'.format(machine)",
    "cycler",
    "lipsum.globals",
    "figure.func",
    "figure.args[0].prose.places[0].unlink()",
    "machine.cycle_angles.tofile('x')",
    "words.update(a=1)",
    "machine ~ ''",
    "machine",
    "say('{gi_frame}', machine)[0].f_builtins",
    "say",
    "words.cover.title.upper()",
)


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize("language", matrix(["en", "vi"], ["vi"]))
@pytest.mark.parametrize("escape", matrix(REFUSED, REFUSED[::4]))
def test_a_sign_that_is_not_in_the_language_is_a_located_fault(school: School, escape: str, language: str) -> None:
    file = school(f"%% foreword\n# A {{{{ unnumbered() }}}}\n\nB {{{{ {escape} }}}}\n", language)
    with pytest.raises(TemplateError, match=rf"ours/{language}\.md:4: .*{UNSAFE[language]}"):
        api.document(api.load(file))


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize("escape", matrix(MISSING, MISSING[::4]))
def test_what_is_no_member_and_no_text_is_a_located_fault(school: School, escape: str) -> None:
    file = school(f"%% foreword\n# A {{{{ unnumbered() }}}}\n\nB {{{{ {escape} }}}}\n")
    with pytest.raises(TemplateError, match=r"ours/en\.md:4: ") as raised:
        api.document(api.load(file))
    assert " object at 0x" not in str(raised.value)


@pytest.mark.usefixtures("here")
def test_a_section_that_is_included_is_one_of_the_words(school: School, tmp_path: Path) -> None:
    (tmp_path / "secret.md").write_text("%% section\nNobody reads this.\n", encoding="utf-8")
    for name in (f"{tmp_path}/secret/section", "../../secret/section", "../en/foreword", "catalogue/../comments/v"):
        file = school(f'%% foreword\n# A {{{{ unnumbered() }}}}\n\n{{% include "{name}" %}}\n')
        with pytest.raises(TemplateError, match=rf"ours/en\.md:4: there is no section {re.escape(name)}"):
            api.document(api.load(file))


GREEDY_TEXTS = {
    "loops": "{% for i in range(9999) %}{% for j in range(9999) %}{% endfor %}{% endfor %}",
    "range": "{% for i in range(99999) %}{% endfor %}",
    "text": "{% set a = 'word ' %}" + "{% set a = a ~ a %}" * 30 + "{{ a }}",
    "sum": "{% set a = 'word ' %}" + "{% set a = a + a %}" * 30 + "{{ a }}",
    "list": "{% set a = [1, 2] %}" + "{% set a = a + a %}" * 30,
    "set": "{% set a %}word {% endset %}" + "{% set a %}{{ a }}{{ a }}{% endset %}" * 30 + "{{ a }}",
    "section": "{% for i in range(9999) %}" + "word " * 100 + "{% endfor %}",
}


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize("greed", matrix(GREEDY_TEXTS, ["loops", "text", "section"]))
def test_a_greedy_text_is_told_with_its_line(school: School, greed: str) -> None:
    file = school(f"%% foreword\n# A {{{{ unnumbered() }}}}\n\n{GREEDY_TEXTS[greed]}\n")
    start = time.monotonic()
    with pytest.raises(TemplateError, match=r"ours/en\.md:4: .*this has more"):
        api.document(api.load(file))
    assert time.monotonic() - start < PATIENCE * TEMPLATES.seconds


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize("deep", ["*" * 3000 + "a" + "*" * 3000, "- " * 3000 + "a", "{% include 'foreword' %}"])
def test_depth_is_told_with_its_line(school: School, deep: str) -> None:
    file = school(f"%% foreword\n# A {{{{ unnumbered() }}}}\n\n{deep}\n")
    with pytest.raises(TemplateError, match=r"ours/en\.md:4: .*nested too deep"):
        api.document(api.load(file))


LABOUR = "{% for i in range(9000) %}{{ figure('scheme', 'fig.s.' ~ i, 'A') }}\n\n{% endfor %}"


@pytest.mark.parametrize("language", matrix(["en", "vi"], ["en"]))
def test_a_greedy_template_is_ended_and_located(school: School, language: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("reportgen.base.process_limits.TEMPLATES", Limits(2, 500))
    file = school(f"%% foreword\n# A {{{{ unnumbered() }}}}\n\n{LABOUR}\n", language)
    # Ended from outside, as on a machine that is busy, it tells the file alone.
    with pytest.raises(TemplateError, match=rf"ours/{language}\.md:[14]: .*{GREEDY[language]}"):
        api.document(api.load(file))


@proof
@pytest.mark.parametrize("engine", ["typst", "latex"])
def test_what_takes_long_to_typeset_is_ended_too(
    school: School, engine: api.Engine, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """A text that is rendered at once, and fills a thousand pages; on a slow machine its time is up a little before."""
    if engine == "latex" and shutil.which("pdflatex") is None:
        pytest.skip("pdflatex is not installed")
    monkeypatch.setattr("reportgen.base.process_limits.TEMPLATES", Limits({"typst": 3, "latex": 1}[engine], 500))
    labour = "{% for i in range(7000) %}word **and** *word* " + "and words " * 50 + "\n\n{% endfor %}"
    file = school(f"%% foreword\n# A {{{{ unnumbered() }}}}\n\n{labour}\n")
    with pytest.raises(TemplateError, match=rf"\.md:\d+: .*{GREEDY['en']}"):
        api.build(file, tmp_path / "out", engine)


def test_a_section_that_is_there_twice_is_told_with_its_file(school: School) -> None:
    """It shows only when the report is put together, in another process."""
    file = school('%% foreword\n# A {{ unnumbered() }}\n\n{{ figure("scheme") }}\n\n{{ figure("scheme") }}\n')
    with pytest.raises(TemplateError, match=r"ours/en\.md:1: two blocks have the key"):
        api.document(api.load(file))


@pytest.mark.usefixtures("here")
@proof
def test_a_task_and_an_exercise_are_bounded_too(school: School) -> None:
    case = api.open_case(school("%% task\n{{ ''.__class__ }}\n"))
    with pytest.raises(TemplateError, match=r"ours/en\.md:2: .*may not use"):
        task_of(case, key_of(case))
    case = api.open_case(school("%% exercise-task\n{{ ''.__class__ }}\n", sample=EXERCISE))
    with pytest.raises(TemplateError, match=r"ours/en\.md:2: .*may not use"):
        task_of(case, key_of(case))


@pytest.mark.parametrize("path", built.TYPESET, ids=lambda path: path.stem)
@pytest.mark.proof
def test_the_sandbox_changes_no_report(school: School, path: Path) -> None:
    """All that the common words use is allowed, and fits within the limits."""
    file = school("A note, and no section.\n", sample=path)
    plain = file.with_name("plain.yaml")
    plain.write_text(file.read_text(encoding="utf-8").replace("  school: ours\n", ""), encoding="utf-8")
    assert text_of(api.document(api.load(file))) == text_of(api.document(api.load(plain)))


@pytest.mark.parametrize(("language", "told"), [("en", "points outside the folder"), ("vi", "dẫn ra ngoài thư mục")])
@pytest.mark.parametrize("link", ["ours", "ours/en.md", "ours/blocks", "ours/report.docx", "ours/blocks/a.yaml"])
def test_a_link_out_of_the_folder_of_a_school_is_refused(
    school: School, tmp_path: Path, link: str, language: Language, told: str
) -> None:
    file = school("%% foreword\n# Ours\n")
    target = tmp_path / "templates" / link
    elsewhere = tmp_path / "elsewhere"
    if target.exists():
        target.rename(elsewhere)
    elif target.suffix:
        elsewhere.touch()
    else:
        elsewhere.mkdir()
    target.parent.mkdir(exist_ok=True)
    target.symlink_to(elsewhere)
    (problem,) = api.check(file, language)
    line = file.read_text(encoding="utf-8").splitlines().index("  school: ours") + 1
    assert (problem.code, problem.location.line, problem.location.column) == ("path-outside", line, 11)
    assert told in str(problem)


@pytest.mark.parametrize("link", ["en.md", "blocks", "report.docx", "blocks/a.yaml"])
def test_the_folder_that_a_command_names_is_judged_by_the_same_rule(
    tmp_path: Path, link: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder, elsewhere = tmp_path / "ours", tmp_path / "elsewhere"
    (folder / link).parent.mkdir(parents=True)
    (folder / "vi.md").write_text("A note.\n", encoding="utf-8")
    elsewhere.mkdir() if link == "blocks" else elsewhere.write_text("%% foreword\n# Ours\n", encoding="utf-8")
    (folder / link).symlink_to(elsewhere)
    monkeypatch.setenv("REPORTGEN_TEMPLATES", str(folder))
    with pytest.raises(TemplateError, match=rf"ours/{re.escape(link)}:1:1: error\[path-outside\]"):
        api.document(api.load(SAMPLE))


GAPS = ("{g.__init__.__globals__}", "{k.__class__}", "{k!r}", "{words[cover]}", "{k:>99999999}", "{k:{g}}", "{_k}", "{")


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize("language", matrix(["en", "vi"], ["en"]))
@pytest.mark.parametrize("gap", matrix(GAPS, GAPS[::3]))
def test_a_gap_of_a_schools_words_names_a_value(school: School, gap: str, language: Language) -> None:
    file = school(f'A note.\n\n%% words\ncaptions:\n  scheme: "Ours {gap}"\n', language)
    with pytest.raises(TemplateError, match=rf"ours/{language}\.md:5:11: .*{UNSAFE[language]}"):
        api.document(api.load(file))


FILLED = {"en": "unknown placeholder in", "vi": "chỗ trống trong"}
UNFILLED = (
    'header: "{nobody}"',
    'variant: "{variant.nothing}"',
    'cover: {no_date: "{}"}',
    'captions: {scheme: "{nobody}"}',
    'captions: {scheme: "{k.label}"}',
    'captions: {velocity: "{k.real}"}',
    'driven: {crank: {balance: "{@}{e.e:value}"}}',
    'driven: {crank: {balance: "{machine}"}}',
)


@pytest.mark.usefixtures("here")
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
    task_of(case, key_of(case))
    drawing_sheets(case)


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("a: " + "[" * 100_000, r"4:15: too-deep"),
        ("a: " + "{a: " * 50_000, r"4:45: too-deep"),
        ('header: "\\x01"', "4:9: a control or private character"),
        ('header: "\\ud800"', "4:9: a control or private character"),
    ],
)
def test_words_that_would_end_the_program_are_a_located_fault(tmp_path: Path, words: str, told: str) -> None:
    """The fast reader of the program's own words would end with the whole process."""
    ours = tmp_path / "en.md"
    ours.write_text(f"A note.\n\n%% words\n{words}\n", encoding="utf-8")
    with pytest.raises(TemplateError, match=rf"en\.md:{told}"):
        load_words((ours, *search_path("en")))


@pytest.mark.usefixtures("here")
def test_a_word_may_have_lines_and_any_sign(school: School) -> None:
    """What joins its gaps with others is looked for by no sign that a word may have."""
    file = school('A note.\n\n%% words\npointing: "{heading} | at {angle} | {angle}"\nheader: |\n  One\n  two\n')
    case = api.open_case(file)
    assert case.words["header"] == "One two"
    assert " | at " in text_of(api.document(case.assignment))


FORMED = {"en": "the same type", "vi": "không cùng dạng"}


MISSHAPEN = [
    ("units: 5", 4, "units"),
    ("cover: [a]", 4, "cover"),
    ("cover:\n  title:", 5, "cover.title"),
    ("cover:\n  title: {a: b}", 5, "cover.title"),
    ("strokes: [One, Two]", 4, "strokes"),
    ("strokes: [One, Two, Three, Four, Five]", 4, "strokes"),
    ("vector:\n  rows: [[One], Two, Three]", 5, "vector.rows"),
]


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize("language", matrix(["en", "vi"], ["vi"]))
@pytest.mark.parametrize(("words", "line", "path"), matrix(MISSHAPEN, MISSHAPEN[3::3]))
def test_a_word_of_another_form_is_a_located_fault(
    school: School, words: str, line: int, path: str, language: Language
) -> None:
    file = school(f"A note.\n\n%% words\n{words}\n", language)
    with pytest.raises(TemplateError, match=rf"ours/{language}\.md:{line}: “{path}” .*{FORMED[language]}"):
        _pages(file)
