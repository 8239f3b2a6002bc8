"""A language that nobody has told the program of: English with every word in another alphabet, in a folder of its own.

All that is made of an assignment is made in it, without a word of English and without a change outside its folder.
"""

from __future__ import annotations

import csv
import io
import re
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml

from reportgen.base.words import sections
from tests.lanes import proof
from tests.report import built

LETTERS = str.maketrans(
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ", "абвгдежзийклмнопрстуфхцчшщАБВГДЕЖЗИЙКЛМНОПРСТУФХЦЧШЩ"
)
KEPT = re.compile(
    r"\{\{.*?\}\}|\{%.*?%\}|\{[^{}]*\}|\$[^$\n]+\$|@(?:fig|tab|sec|eq)\.[\w.]*\w"
    r"|<[^>]*>|\*reportgen[^*]*\*|\w+\.\w+",
    re.DOTALL,
)
"""What is no word of a language: names in braces, gaps, formulas, references, names of files and commands."""
WORD = re.compile(r"[A-Za-z]{4,}")
UNTOUCHED = frozenset({"units", "pieces", "texts"})
NAMES = frozenset({"reportgen", "compare", "assignment", "yaml", "answers", "hint", "scale"})
"""Of commands, options and files, and an id of one word."""
SHOWN = ("engine-twin-05", "shaper-01")


def told(text: str) -> str:
    """A text with its words in the other alphabet."""
    end, parts = 0, []
    for kept in KEPT.finditer(text):
        parts += [text[end : kept.start()].translate(LETTERS), kept[0]]
        end = kept.end()
    return "".join((*parts, text[end:].translate(LETTERS)))


def table(words: Any) -> Any:
    match words:
        case str():
            return told(words)
        case list():
            return [table(word) for word in words]
        case dict():
            return {key: value if key in UNTOUCHED else table(value) for key, value in words.items()}
    return words


def as_yaml(text: str) -> str:
    return yaml.safe_dump(
        table(yaml.load(text, Loader=yaml.BaseLoader)), allow_unicode=True, sort_keys=False, width=10_000
    )


def make_language(templates: Path) -> None:
    """The folder `xx` beside that of English."""
    own, english = templates / "xx", templates / "en"
    for file in sorted(english.rglob("*")):
        made = own / file.relative_to(english)
        if file.is_dir():
            continue
        made.parent.mkdir(parents=True, exist_ok=True)
        if file.suffix == ".md":
            parts = (
                f"%% {name}\n" + (as_yaml(one.text) if name in ("words", "fields") else told(one.text))
                for name, one in sections(file).items()
                if name != "new"
            )
            kept = [f"%% new\n{one.text}" for name, one in sections(file).items() if name == "new"]
            made.write_text("\n".join((*parts, *kept)), encoding="utf-8")
        elif file.name != "language.yaml":
            made.write_text(as_yaml(file.read_text(encoding="utf-8")), encoding="utf-8")
    (own / "language.yaml").write_text(
        "name: Шш\ncode: xx-XX\ndecimal: ','\ntypst: {lang: xx, hyphenate: true}\nword: {size: 14}\n"
        "page: {left: 30, right: 15, top: 20, bottom: 20}\nblock: gost\ndraft: [shaper]\n"
        "units: {rpm: рпм, m: м, mm: мм, cm: цм, s: с, N: Н, kg: кг, J: Ж, W: В, rad: рад}\n",
        encoding="utf-8",
    )


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the program with the further language, and nothing else that is new."""
    from tests.documents import copy_of_repository

    folder = copy_of_repository(tmp_path_factory.mktemp("xx"))
    make_language(folder / "templates")
    return folder


def run(place: Path, *arguments: str) -> str:
    done = subprocess.run(
        [sys.executable, "-m", "reportgen.cli", *arguments],
        cwd=place,
        env={"PATH": "/usr/bin:/bin", "PYTHONPATH": str(place), "HOME": str(place)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


ENGLISH = frozenset(
    word.casefold()
    for file in sorted((built.ROOT / "templates" / "en").rglob("*"))
    if file.is_file()
    for line in file.read_text(encoding="utf-8").splitlines()
    for word in WORD.findall(KEPT.sub(" ", line))
)


def english(text: str, name: str) -> set[str]:
    """English words of a text that its assignment does not have itself."""
    own = (built.ROOT / "assignments" / f"{name}.yaml").read_text(encoding="utf-8")
    given = {word.casefold() for word in WORD.findall(own)} | NAMES
    # The ids of quantities are the same in every language.
    words = WORD.findall(re.sub(r"\w+(\.\s?\w+)+", " ", text))
    return {word for word in map(str.casefold, words) if word in ENGLISH} - given


def test_the_command_lists_its_kinds_and_which_are_drafts(place: Path) -> None:
    listed = run(place, "kinds", "--lang", "xx").splitlines()
    assert [line.split()[0] for line in listed] == [line.split()[0] for line in run(place, "kinds").splitlines()]
    drafts = [line.split()[0] for line in listed if told("draft") in line]
    assert drafts == ["shaper"]


@proof
def test_its_words_are_those_of_reference(place: Path) -> None:
    """Said in the language itself; only terms differ, which the glossary does not have in it."""
    assert "error" not in run(place, "words", "xx")


# --- all that is made -------------------------------------------------------------------------------


def of_pdf(data: bytes) -> str:
    import pymupdf

    with pymupdf.open(stream=data) as document:
        return "\n".join(page.get_text() for page in document)


def of_html(data: bytes) -> str:
    text = re.sub(r"<(script|style|svg)\b.*?</\1>", " ", data.decode(), flags=re.DOTALL)
    return re.sub(r"<[^>]*>", " ", text)


def of_docx(data: bytes) -> str:
    with zipfile.ZipFile(io.BytesIO(data)) as package:
        parts = [name for name in package.namelist() if re.match(r"word/(document|header|footer)\d*\.xml", name)]
        texts = (re.sub(r"<w:instrText.*?</w:instrText>", " ", package.read(name).decode()) for name in parts)
        return " ".join(re.sub(r"<[^>]*>", " ", text) for text in texts)


def of_xlsx(data: bytes) -> str:
    import openpyxl

    book = openpyxl.load_workbook(io.BytesIO(data))
    return "\n".join(
        str(value)
        for sheet in book
        for row in sheet.iter_rows(values_only=True)
        # Ids are names of the program's own, the same in every language.
        for value in row[1:]
        if value is not None
    )


def of_dxf(data: bytes) -> str:
    import ezdxf

    layout = ezdxf.read(io.StringIO(data.decode())).modelspace()
    return "\n".join(text.dxf.text for text in layout.query("TEXT")) + "".join(
        text.plain_text() for text in layout.query("MTEXT")
    )


READ: dict[str, Callable[[bytes], str]] = {
    ".pdf": of_pdf,
    ".html": of_html,
    ".docx": of_docx,
    ".xlsx": of_xlsx,
    ".dxf": of_dxf,
}


@pytest.fixture(scope="module")
def made(place: Path) -> Path:
    for name in SHOWN:
        file = f"assignments/{name}.yaml"
        run(place, "build", file, "--lang", "xx", "--format", "pdf,html,docx")
        run(place, "sheet", file, "--lang", "xx")
        run(place, "key", file, "--lang", "xx")
    (place / "roster.csv").write_text("id,name\n" + "".join(f"{name},Ан Нгуен\n" for name in SHOWN), encoding="utf-8")
    run(place, "batch", "roster.csv", "--assignments", "assignments", "--make", "task", "--lang", "xx", "--out", "out")
    return place / "out"


def files(made: Path, name: str) -> Iterator[Path]:
    """What was made of an assignment; the folder of a batch has a number behind its name."""
    folders = (made / name, *made.glob(f"{name.replace('-', '_')}-*"))
    yield from (path for folder in folders for path in sorted(folder.rglob("*")) if path.suffix in READ)


@proof
@pytest.mark.parametrize("name", SHOWN)
def test_nothing_that_is_made_has_a_word_of_english(made: Path, name: str) -> None:
    kinds = {path.name for path in files(made, name)}
    assert {"report.pdf", "report.html", "report.docx", "key.pdf", "task.pdf", "answers.xlsx", "sheet-1.dxf"} <= kinds
    texts = {path.name: READ[path.suffix](path.read_bytes()) for path in files(made, name)}
    assert {file: english(text, name) for file, text in texts.items() if english(text, name)} == {}
    assert all(re.search("[а-щ]{4}", text) for text in texts.values())


@proof
def test_numbers_and_units_are_those_of_the_language(made: Path) -> None:
    text = of_pdf((made / "engine-twin-05" / "report.pdf").read_bytes())
    assert re.search(r"\d,\d+\s*м/с", text)
    assert not re.search(r"\d\s*(mm|m/s|N·m|rad/s)\b", text)


def filled(made: Path, name: str, wrong: str) -> bytes:
    """The answer sheet with the numbers of the key, twice those of ids that begin so."""
    import openpyxl

    run(made.parent, "key", f"assignments/{name}.yaml", "--lang", "xx", "--format", "csv")
    rows = list(csv.reader((made / name / "key.csv").read_text(encoding="utf-8-sig").splitlines()))[1:]
    values = {(row[0], row[5]): float(row[6].replace(",", ".")) for row in rows if row[6]}
    book = openpyxl.load_workbook(next(made.glob(f"{name.replace('-', '_')}-*")) / "answers.xlsx")
    sheet = book.worksheets[0]
    head = next(row for row in sheet.iter_rows() if row[0].value == told("id"))
    places = {cell.column: "".join(re.findall(r"\d+", str(cell.value))) for cell in head[4:]}
    for row in sheet.iter_rows(min_row=head[0].row + 1):
        for cell in row[4:]:
            value = values.get((str(row[0].value), places[cell.column]))
            if cell.value is None and value is not None:
                cell.value = 2 * value if wrong and str(row[0].value).startswith(wrong) else value
    data = io.BytesIO()
    book.save(data)
    return data.getvalue()


@proof
def test_answers_in_it_are_marked_and_told_of(made: Path) -> None:
    """A sheet with the numbers of the key has all points, one with wrong rotations fewer; both are told so in xx."""
    place, name = made.parent, "shaper-01"
    folder, tasks = place / "handed", place / "tasks"
    folder.mkdir()
    tasks.mkdir()
    shutil.copy(place / "assignments" / f"{name}.yaml", tasks)
    points = {}
    for wrong in ("", "turn."):
        (folder / f"{name}.xlsx").write_bytes(filled(made, name, wrong))
        out = place / f"graded{wrong}"
        run(place, "grade", f"handed/{name}.xlsx", "--assignments", "tasks", "--lang", "xx", "--out", out.name)
        grades = list(csv.DictReader((out / "grades.csv").read_text(encoding="utf-8-sig").splitlines()))
        points[wrong] = grades[0]
        feedback = [READ[path.suffix](path.read_bytes()) for path in out.rglob("*.pdf")]
        assert feedback
        assert [english(text, name) for text in feedback if english(text, name)] == []
    given, out_of = told("points"), told("out of")
    assert points[""][given] == points[""][out_of]
    assert float(points["turn."][given]) < float(points["turn."][out_of])
