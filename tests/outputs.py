"""Compare every output of the package before and after a change of its structure.

    python -m tests.outputs write DIR [PART…]      before and after a change
    python -m tests.outputs write DIR FILE.yaml…   of other assignment files
    python -m tests.outputs compare BEFORE AFTER   what differs, and exit code 1 if anything does

It calls the command line only, so it does not depend on the code that changes.  For each file in `assignments/` and
its folders, in Vietnamese and English, it writes: results, tables, key, task and answer sheet, that sheet filled in
with some mistakes and marked, the drawing sheets (PDF and DXF), the page for a browser with its animation, the Word
file's text; with each typesetter the report's source and its PDF's words and strokes with their places; and the marks
and feedback of the example class.  In the other languages it writes the key, the Word file and the report of the first
file of each kind.  A PART is a word of the jobs' names ("engine-twin", "typst", "key", "class", "sheet", "page",
"docx", "marks", "zh"); only jobs with all of them are run.
"""

from __future__ import annotations

import base64
import hashlib
import json
import math
import re
import shutil
import struct
import sys
import tempfile
import zipfile
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from itertools import zip_longest
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
CLASS = ROOT / "assignments" / "class-demo"
FILES = [path for path in sorted((ROOT / "assignments").rglob("*.yaml")) if CLASS not in path.parents]
LANGUAGES = ("vi", "en")
ENGINES = ("typst", "latex")

RELATIVE, ABSOLUTE = 1e-10, 1e-8
"""Largest differences of unrounded results (SI) from rounding: another order of the same operations."""
JOINT = '"#"'
"""Boundary between two strings in typst's source, which read as one."""
SHOWN = 12
"""Largest number of differing lines shown for a file."""
EVERY, WRONG = 17, 1.13
"""In a filled sheet, the second answer and then every `EVERY`-th is wrong by the factor `WRONG`."""

PACKED = re.compile(r"(?<=\")[A-Za-z0-9+/]{400,}={0,2}(?=\")")
"""The packed samples of an animation."""
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")


# --- writing --------------------------------------------------------------------------------------


def run(*arguments: str | Path) -> str:
    """Return the output of a command, including its error messages."""
    from typer.testing import CliRunner

    from reportgen.cli import app

    done = CliRunner().invoke(app, [str(argument) for argument in arguments])
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        raise done.exception
    return f"{done.output}exit {done.exit_code}\n"


def page_text(pdf: Path) -> str:
    """Return the words and strokes of a PDF with their places, one per line, to a hundredth of a point."""
    import pymupdf

    def lines() -> Iterator[str]:
        with pymupdf.open(pdf) as document:
            for number, page in enumerate(document, 1):
                yield f"page {number} {page.rect}"
                for x, y, _, _, word, *_ in page.get_text("words"):
                    yield f"{x:.2f} {y:.2f} {word}"
                for path in page.get_cdrawings():
                    parts = (
                        " ".join(f"{number:.2f}" for part in item[1:] for number in _flat(part))
                        for item in path["items"]
                    )
                    yield f"path {path.get('width')} {path.get('color')} {path.get('fill')} " + "; ".join(parts)

    return "\n".join(lines()) + "\n"


def _flat(part: object) -> Iterator[float]:
    if isinstance(part, (int, float)):
        yield float(part)
    elif isinstance(part, (tuple, list)):
        for inner in part:
            yield from _flat(inner)


def workbook_text(path: Path) -> str:
    """Return the cells of a workbook with their comments, one per line."""
    import openpyxl

    book = openpyxl.load_workbook(path)
    return "".join(
        f"{sheet.title}!{cell.coordinate} {cell.value!r} {cell.comment.text if cell.comment else ''}\n"
        for sheet in book
        for row in sheet.iter_rows()
        for cell in row
        if cell.value is not None
    )


def browser_text(path: Path) -> str:
    """Return the elements of a page, one per line, with the samples of its animation as numbers."""
    text = path.read_text(encoding="utf-8").replace("><", ">\n<")
    return PACKED.sub(lambda found: " ".join(f"{number:.7g}" for number in _floats(found[0])), text)


def _floats(packed: str) -> Iterator[float]:
    raw = base64.b64decode(packed)
    return (number for (number,) in struct.iter_unpack("<f", raw[: len(raw) // 4 * 4]))


def word_text(path: Path) -> str:
    """Return the elements of the parts of a Word file, one per line, with digests of pictures."""
    with zipfile.ZipFile(path) as parts:
        return "".join(f"--- {name}\n{_part(name, parts.read(name))}\n" for name in sorted(parts.namelist()))


def _part(name: str, content: bytes) -> str:
    if name.endswith((".xml", ".rels")):
        return content.decode("utf-8").replace("><", ">\n<")
    return hashlib.sha256(content).hexdigest()


READERS: dict[str, Callable[[Path], str]] = {
    ".pdf": page_text,
    ".xlsx": workbook_text,
    ".html": browser_text,
    ".docx": word_text,
}


def take(folder: Path, out: Path) -> None:
    """Write the files that a command left in `folder` to `out`, each as text."""
    for file in sorted(path for path in folder.rglob("*") if path.is_file()):
        target = out / file.relative_to(folder)
        target = target.with_name(f"{target.name}.txt")
        target.parent.mkdir(parents=True, exist_ok=True)
        read = READERS.get(file.suffix, lambda path: path.read_text(encoding="utf-8", errors="replace"))
        target.write_text(read(file), encoding="utf-8")


def say(out: Path, name: str, text: str, place: Path) -> None:
    """Write printed text without the name of a temporary folder."""
    out.mkdir(parents=True, exist_ok=True)
    text = text.replace(str(place), "DIR").replace(str(ROOT), "ROOT")
    (out / f"{name}.txt").write_text(text, encoding="utf-8")


def report(out: Path, file: Path, engine: str, language: str, place: Path) -> None:
    made = place / "made"
    text = run("build", file, "--engine", engine, "--lang", language, "--keep-source", "--out", made)
    say(out, "build", text, place)
    take(made, out)


def results(out: Path, file: Path, language: str, place: Path) -> None:
    say(out, "solve", run("solve", file, "--lang", language), place)
    say(out, "json", run("solve", file, "--lang", language, "--json", "-"), place)


def key(out: Path, file: Path, language: str, place: Path) -> None:
    made = place / "made"
    text = run("key", file, "--lang", language, "--format", "pdf,xlsx,csv,json", "--out", made)
    say(out, "key", text, place)
    take(made, out)


def task(out: Path, file: Path, language: str, place: Path) -> None:
    (place / "roster.csv").write_text(f"id,name\n{file.stem},A B\n", encoding="utf-8")
    shutil.copy(file, place)
    made = place / "made"
    files = ("--assignments", place, "--make", "task", "--jobs", "1", "--out", made)
    say(out, "batch", run("batch", place / "roster.csv", *files, "--lang", language), place)
    for folder in (path for path in made.iterdir() if path.is_dir()):
        take(folder, out)


def sheets(out: Path, file: Path, language: str, place: Path) -> None:
    made = place / "made"
    say(out, "sheet", run("sheet", file, "--lang", language, "--out", made), place)
    take(made, out)


def page(out: Path, file: Path, language: str, place: Path) -> None:
    made = place / "made"
    say(out, "page", run("build", file, "--format", "html", "--lang", language, "--out", made), place)
    take(made, out)


def word(out: Path, file: Path, language: str, place: Path) -> None:
    made = place / "made"
    say(out, "docx", run("build", file, "--format", "docx", "--lang", language, "--out", made), place)
    take(made, out)


def marks(out: Path, file: Path, language: str, place: Path) -> None:
    """Fill in the answer sheet from the key with some errors, then compare and mark it."""
    assignments, made, marked = place / "assignments", place / "made", place / "marked"
    assignments.mkdir()
    shutil.copy(file, assignments)
    (place / "roster.csv").write_text(f"id,name\n{file.stem},A B\n", encoding="utf-8")
    files = ("--assignments", assignments, "--make", "task", "--jobs", "1", "--out", made)
    run("batch", place / "roster.csv", *files, "--lang", language)
    run("key", file, "--lang", language, "--format", "json", "--out", made)
    sheet = place / f"{file.stem}.xlsx"
    fill(next(made.rglob("answers.xlsx")), json.loads((made / file.stem / "key.json").read_text("utf-8")), sheet)
    say(out, "compare", run("compare", file, sheet, "--hint", "--lang", language), place)
    text = run("grade", sheet, "--assignments", assignments, "--lang", language, "--out", marked)
    say(out, "grade", text, place)
    take(marked, out)


def fill(empty: Path, key: Mapping[str, Any], filled: Path) -> None:
    """Write the key's values into an empty answer sheet."""
    import openpyxl

    rows = {row["id"]: row["values"] for row in key["rows"]}
    labels = [str(label) for label in key["positions"]]
    book = openpyxl.load_workbook(empty)
    count = 0
    for page in book:
        columns: dict[int, str] = {}
        for cells in page.iter_rows():
            first = cells[0].value
            if first in ("mã", "id"):
                columns = {cell.column: str(cell.value).split()[-1] for cell in cells[4:] if cell.value}
            if first not in rows:
                continue
            for cell in cells[4:]:
                label, values = columns.get(cell.column, ""), rows[first]
                index = labels.index(label) if label in labels and len(values) > 1 else 0
                if cell.value is not None or (label in labels) != (len(values) > 1) or values[index] is None:
                    continue
                count += 1
                cell.value = values[index] * (WRONG if count % EVERY == 2 else 1.0)
    if not count:
        raise ValueError(f"{empty}: no answer was filled in")
    book.save(filled)


def example_class(out: Path, language: str, place: Path) -> None:
    drawn, marked = place / "variants", place / "marked"
    say(out, "variants", run("variants", CLASS / "spec.yaml", CLASS / "roster.csv", "--out", drawn), place)
    take(drawn, out / "variants")
    policy = ("--policy", CLASS / "policy.yaml", "--lang", language)
    text = run("grade", CLASS / "sheets", "--assignments", drawn, *policy, "--out", marked)
    say(out, "grade", text, place)
    take(marked, out / "marked")
    for sheet in sorted((CLASS / "sheets").iterdir()):
        text = run("compare", drawn / f"{sheet.stem}.yaml", sheet, "--hint", "--lang", language)
        say(out, f"compare-{sheet.stem}", text, place)


def general(out: Path, place: Path) -> None:
    say(out, "schema", run("schema"), place)
    for language in LANGUAGES:
        say(out, f"kinds-{language}", run("kinds", "--lang", language), place)
        for kind in re.findall(r"^([a-z-]+)  ", run("kinds"), re.MULTILINE):
            say(out, f"new-{kind}-{language}", run("new", kind, "--lang", language), place)


def jobs(files: list[Path]) -> Iterator[tuple[str, Callable[..., None], tuple[object, ...]]]:
    yield "general", general, ()
    for language in LANGUAGES:
        yield f"class {language}", example_class, (language,)
    for file in files:
        for language in LANGUAGES:
            yield f"{file.stem} {language} results", results, (file, language)
            yield f"{file.stem} {language} key", key, (file, language)
            yield f"{file.stem} {language} task", task, (file, language)
            yield f"{file.stem} {language} sheet", sheets, (file, language)
            yield f"{file.stem} {language} page", page, (file, language)
            yield f"{file.stem} {language} docx", word, (file, language)
            yield f"{file.stem} {language} marks", marks, (file, language)
            for engine in ENGINES:
                yield f"{file.stem} {language} {engine}", report, (file, engine, language)
    for language in sorted(set(languages()) - set(LANGUAGES)):
        for file in first_of_each_kind(files):
            yield f"{file.stem} {language} key", key, (file, language)
            yield f"{file.stem} {language} docx", word, (file, language)
            yield f"{file.stem} {language} typst", report, (file, "typst", language)


def languages() -> list[str]:
    """Return the languages of the templates, by their folders."""
    return sorted(path.parent.name for path in (ROOT / "templates").glob("*/language.yaml"))


def first_of_each_kind(files: list[Path]) -> list[Path]:
    """Return the first file of each kind; a coursework of parts without a kind counts as a kind."""
    kinds: dict[str, Path] = {}
    for file in files:
        kind = re.search(r"^kind: *(\S+)", file.read_text(encoding="utf-8"), re.MULTILINE)
        kinds.setdefault(kind[1] if kind else file.stem, file)
    return list(kinds.values())


def do(name: str, job: Callable[..., None], arguments: tuple[object, ...], out: Path) -> str:
    with tempfile.TemporaryDirectory() as folder:
        job(out / name.replace(" ", "/"), *arguments, Path(folder))
    return name


def write(out: Path, parts: list[str]) -> None:
    if out.exists():
        shutil.rmtree(out)
    others = [Path(part) for part in parts if part.endswith(".yaml")]
    words = [part for part in parts if not part.endswith(".yaml")]
    chosen = [job for job in jobs(others or FILES) if all(word in job[0] for word in words)]
    with ProcessPoolExecutor() as pool:
        for done in [pool.submit(do, *job, out) for job in chosen]:
            done.result()
    print(f"{len(chosen)} jobs, {sum(path.is_file() for path in out.rglob('*'))} files")


# --- comparing ------------------------------------------------------------------------------------


def alike(one: str, other: str) -> bool:
    """Return True if two lines agree, numbers within rounding; strings of a source may be split differently."""
    one, other = one.replace(JOINT, ""), other.replace(JOINT, "")
    if one == other:
        return True
    if NUMBER.sub("#", one) != NUMBER.sub("#", other):
        return False
    pairs = zip(NUMBER.findall(one), NUMBER.findall(other), strict=True)
    return all(math.isclose(float(a), float(b), rel_tol=RELATIVE, abs_tol=ABSOLUTE) for a, b in pairs)


def differences(before: Path, after: Path) -> Iterator[str]:
    names = {path.relative_to(root) for root in (before, after) for path in root.rglob("*.txt")}
    both = [name for name in sorted(names) if (before / name).exists() and (after / name).exists()]
    yield from (f"only in {before}: {name}" for name in sorted(names) if not (after / name).exists())
    yield from (f"only in {after}: {name}" for name in sorted(names) if not (before / name).exists())
    for name in both:
        one, other = ((root / name).read_text(encoding="utf-8") for root in (before, after))
        if one == other:
            continue
        unlike = [
            (number, a, b)
            for number, (a, b) in enumerate(zip_longest(one.splitlines(), other.splitlines(), fillvalue="(nothing)"), 1)
            if not alike(a, b)
        ]
        if unlike:
            yield f"{name}: {len(unlike)} lines differ"
            for number, a, b in unlike[:SHOWN]:
                yield f"  {number}: {a[:200]}\n  {' ' * len(str(number))}> {b[:200]}"


def compare(before: Path, after: Path) -> int:
    if not any(after.rglob("*.txt")):
        print(f"nothing in {after}")
        return 2
    found = list(differences(before, after))
    print(*found, sep="\n", end="\n" * bool(found))
    print("different" if found else "equal")
    return int(bool(found))


def main(arguments: list[str]) -> int:
    match arguments:
        case ["write", out, *parts]:
            write(Path(out), parts)
            return 0
        case ["compare", before, after]:
            return compare(Path(before), Path(after))
        case _:
            print(__doc__)
            return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
