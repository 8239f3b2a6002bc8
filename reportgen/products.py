"""What is made of one assignment file: the report, the student's task, the key; each as files by name.

Every maker is a function of the file, the typesetter and the language alone, so that it can run anywhere.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from reportgen import api
from reportgen.answers.key import make_key
from reportgen.api import Engine
from reportgen.case import open_case
from reportgen.notation.numbers import Language

Maker = Callable[[Path, Engine, Language | None], Mapping[str, bytes]]
"""Makes the files of one product, by name, of an assignment file."""

KEY_FORMATS = ("pdf", "xlsx", "csv", "json")


def report_files(path: Path, engine: Engine, language: Language | None) -> Mapping[str, bytes]:
    """The complete report."""
    return {"report.pdf": api.typeset(api.document(api.load(path, language)), engine)[1]}


def task_files(path: Path, engine: Engine, language: Language | None) -> Mapping[str, bytes]:
    """The student's handout, and the answer sheet to fill in; no answer is in them."""
    from reportgen.answers.paper import task
    from reportgen.answers.sheet import answer_book
    from reportgen.workbook import write_xlsx

    case = open_case(path, language)
    key = make_key(case)
    return {"task.pdf": api.typeset(task(case, key), engine)[1], "answers.xlsx": write_xlsx(answer_book(key))}


def key_files(
    path: Path, engine: Engine, language: Language | None, formats: Sequence[str] = ("pdf", "xlsx")
) -> Mapping[str, bytes]:
    """The answer key in some of `KEY_FORMATS`."""
    from reportgen.answers.key_files import key_book, key_data, key_document, key_rows
    from reportgen.workbook import write_csv, write_xlsx

    case = open_case(path, language)
    key = make_key(case)

    def data() -> bytes:
        text = json.dumps(key_data(key), ensure_ascii=False, allow_nan=False, indent=1)
        return f"{text}\n".encode()

    makers: Mapping[str, Callable[[], bytes]] = {
        "pdf": lambda: api.typeset(key_document(key, case.title), engine)[1],
        "xlsx": lambda: write_xlsx(key_book(key)),
        "csv": lambda: write_csv(key_rows(key)),
        "json": data,
    }
    return {f"key.{name}": makers[name]() for name in formats}


MAKERS: Mapping[str, Maker] = {"task": task_files, "report": report_files, "key": key_files}
"""What a batch can make, by the name that `--make` takes."""


def put(folder: Path, files: Mapping[str, bytes]) -> list[Path]:
    """Write the files of a product, each in one step; raises `OutputError`."""
    with api.reported():
        folder.mkdir(parents=True, exist_ok=True)
        for name, content in files.items():
            api.replace(folder / name, content)
    return [folder / name for name in files]
