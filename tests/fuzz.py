"""Fuzz files from a seed: each must give a result or a located fault, within a time limit.

`python -m tests.fuzz [CASES] [SEED]` tries any number of them; `tests/test_fuzz.py` hundreds.
"""

from __future__ import annotations

import json
import os
import random
import re
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from reportgen import api
from reportgen.base.errors import ReportgenError
from reportgen.base.files import folder as kept_in
from reportgen.base.records import replace
from reportgen.base.template_folders import search_path, templates
from reportgen.base.words import load_words, sections
from reportgen.case import MachineAnalysis
from reportgen.case.answer_key import Key
from reportgen.cases import MachineCase, open_case
from reportgen.classes.roster import read_roster
from reportgen.classes.variant_draw import Draw, fault_finder
from reportgen.classes.variant_spec import read_spec
from reportgen.document import Figure, Plate
from reportgen.document.template_rendering import Prose
from reportgen.handin.drawing_file import wanted_plans
from reportgen.handin.drawing_reader import DrawnLocation, WantedPlans
from reportgen.handin.dxf_corrections import RedVector, with_corrections
from reportgen.handin.file_kinds import read_file
from reportgen.handin.word_comments import MarginNote, with_comments
from reportgen.handin.word_file import open_word
from reportgen.marking.answer_sheet import answer_book, read_submission
from reportgen.marking.blank_report import frame_of
from reportgen.marking.marking_policy import read_policy
from reportgen.marking.task_paper import task_of
from reportgen.marking.toleranced_key import key_of
from reportgen.report.context import ReportContext
from reportgen.report.template_names import names
from reportgen.sheets.title_block import FIELDS, blocks, read_block
from reportgen.workbook import write_csv, write_xlsx
from reportgen.workbook.letterhead import read_letterhead
from reportgen.writers import word
from reportgen.writers.word_styles import merged, styles
from tests.handin.drawings import Manner, draw, true_plans
from tests.spoiling import (
    HOSTILE,
    element,
    extreme,
    letter,
    scaled,
    spoilt,
    spoilt_bytes,
    spoilt_lines,
    spoilt_package,
    value,
)

ASSIGNMENTS = sorted(Path("assignments").glob("*.yaml"))
DEMO = Path("assignments/class-demo")
MOST_SECONDS = 2.0
"""Largest processor time (s) for one file, which excludes other work on the machine."""
MOST_SECONDS_OF_A_CLASS = 10.0
"""The same for a spec, of which a whole class is drawn and each variant tried."""
AGREE = 1e-9
"""Largest difference between the two torques, as a share of the greatest torque."""
FULL = 16
"""One in this many valid assignments is computed to the last printed number."""

EXECUTED = "executed"
"""The file that a text would write if it were executed."""
REACHING = (
    "{{ cycler.__init__.__globals__.os.mkdir('EXECUTED') }}",
    "{{ ''.__class__.__mro__[1].__subclasses__() }}",
    "{{ machine.cycle_angles.tofile('EXECUTED') }}",
    "{{ figure.args[0].prose.places[0].rename('EXECUTED') }}",
    "{{ words.update(a=1) }}",
    "{{ 'a{0.__class__}'.format(count) }}",
    "{% include '../report' %}",
    "{% for i in range(10 ** 9) %}x{% endfor %}",
    "{{ count / 0 }}",
    "{{ symbol('nowhere') }}",
    "{% if count %}",
    "{% endif %}",
    "{{ foreword }}",
    "%% words\nvariant: '{variant.__class__}'\n",
    "%% words\nunits: 5\n",
    "%% ",
    "$x$",
    "@fig.nowhere",
    "| a | b |\n",
)
"""Content tried in a template; each gives a fault or has no effect."""
GAPS = ("{nobody}", "{}", "{0}", "{k.real.imag}", "{k:d}", "{{", "{", "", "5", "{k!r}")
"""Text tried in place of a placeholder of a short word."""
TABLES = ("../roster.csv", "/etc/passwd", "../../../../../etc/passwd", "roster.csv", ".", "nowhere.csv", "~/roster.csv")


@dataclass(frozen=True, slots=True)
class Outcome:
    """The outcome of one file: its number, its kind, its result, the seconds taken, and the error."""

    number: int
    kind: str
    came_to: str
    seconds: float
    wrong: str = ""


# --- trying -----------------------------------------------------------------------------------------


def _assignment(number: int, chance: random.Random, folder: Path) -> None:
    file = folder / "a.yaml"
    _put(file, spoilt(_text(chance.choice(ASSIGNMENTS)), chance))
    case = MachineCase(api.load(file))
    torque, by_work = case.analysis.torque, case.analysis.torque_by_work
    largest = float(np.abs(torque).max())
    # Without a load that moves, both torques are rounding of what the joints hand on.
    dust = 1e-12 * max((float(np.abs(load.force).max()) for load in case.analysis.loads), default=0.0)
    assert np.abs(torque - by_work).max() <= AGREE * largest + dust, "the two torques differ"
    json.dumps(api.solve(case.assignment), allow_nan=False)
    if number % FULL == 0:
        assert case.ledger.families


def _roster(number: int, chance: random.Random, folder: Path) -> None:
    file = folder / "roster.csv"
    _put(file, spoilt(_text(DEMO / "roster.csv"), chance))
    read_roster(file)


def _spec(number: int, chance: random.Random, folder: Path) -> None:
    file = folder / "spec.yaml"
    text = _text(DEMO / "spec.yaml") + (f"\nvariants: {chance.choice(TABLES)}\n" if number % 4 == 0 else "")
    _put(file, spoilt(text, chance))
    spec = read_spec(file)
    list(Draw(spec, fault_finder(spec)).each(read_roster(DEMO / "roster.csv")))


def _policy(number: int, chance: random.Random, folder: Path) -> None:
    file = folder / "policy.yaml"
    _put(file, spoilt(_text(DEMO / "policy.yaml"), chance))
    read_policy(file)


def _block(number: int, chance: random.Random, folder: Path) -> None:
    file = folder / "block.yaml"
    _put(file, spoilt(_text(chance.choice(list(blocks().values()))), chance))
    read_block(file).scene({name: chance.choice((*HOSTILE, "Nguyễn Văn An")) for name in FIELDS})


def _template(number: int, chance: random.Random, folder: Path) -> None:
    """Try a section of a school that accesses more than it may; in this process, because it is bounded anyway."""
    report = _report()
    language, kind = report.assignment.language, report.assignment.kind
    file = folder / f"{language}.md"
    text = _text(templates() / language / "report.md")
    whole = chance.choice([part for part in text.split("\n%% ")[1:] if part.split("\n")[0] in ("foreword", "given")])
    at = chance.randrange(len(whole))
    reaching = chance.choice((*REACHING, "", "")).replace("EXECUTED", str(folder / EXECUTED))
    _put(file, spoilt(f"%% {whole[:at]}{reaching}{whole[at:]}\n", chance))
    places = (file, *search_path(language, kind))
    load_words(places)
    prose = Prose(places)
    for name in sections(file).keys() - {"words"}:
        prose.render(name, names(report))


def _words(number: int, chance: random.Random, folder: Path) -> None:
    """Try some short words as a school may write them, with other placeholders or spoilt, on all their pages."""
    file = folder / "en.md"
    part = chance.choice(re.split(r"\n(?=\w)", _text(templates() / "en" / "words.yaml")))
    if chance.random() < 0.5:
        part = spoilt(part, chance)
    if gaps := list(re.finditer(r"{\w*}", part)):
        gap = chance.choice(gaps)
        part = part[: gap.start()] + chance.choice(GAPS) + part[gap.end() :]
    _put(file, f"%% words\n{part}\n")
    case = replace(_case())
    vars(case)["words"] = load_words((file, *case.places))
    case.document()
    task_of(case, key_of(case))


def _letterhead(number: int, chance: random.Random, folder: Path) -> None:
    """Try a school's Word file with a part spoilt as a text or as elements, or with some bytes changed."""
    file = folder / "report.docx"
    content = spoilt_package(_word_file(), r"document|styles|header|footer", (element, value, letter), chance)
    file.write_bytes(spoilt_bytes(content, chance, (1, 20)) if number % 8 == 0 else content)
    merged(styles("Times New Roman", 13.0, "en", close=False, room=160.0), read_letterhead(file, "en").styles, "en")


@cache
def _word_file() -> bytes:
    """Return a report that a school may use as its own look."""
    case = open_case(Path("assignments/plane-motion/01.yaml"), "en")
    return word.write(replace(case.document(), blocks=()), lambda _: ())


@cache
def _case() -> MachineAnalysis:
    case = open_case(Path("assignments/slotted-lever-01.yaml"), "en")
    assert isinstance(case, MachineAnalysis)
    return case


@cache
def _report() -> ReportContext:
    return ReportContext(_case())


def _sheet(number: int, chance: random.Random, folder: Path) -> None:
    """Try a sheet as CSV, spoilt as a text, or as a workbook with some bytes changed."""
    key, csv, xlsx = _key()
    if number % 2:
        file = folder / "sheet.csv"
        _put(file, spoilt(csv, chance))
    else:
        file = folder / "sheet.xlsx"
        file.write_bytes(spoilt_bytes(xlsx, chance))
    read_submission(file, key)


def _handed_in(number: int, chance: random.Random, folder: Path) -> None:
    """Try a submitted report with its text spoilt as a text or as elements, or with some bytes changed."""
    file = folder / "handed.docx"
    changes = (element, value, letter, scaled, extreme)
    content = spoilt_package(_report_file(), "word/document.xml", changes, chance, (1, 3, 9))
    content = spoilt_bytes(content, chance, (1, 20)) if number % 8 == 0 else content
    file.write_bytes(content)
    key = _key()[0]
    reading = read_file(file, content, key, "en")
    remarks = [MarginNote(answer.text, getattr(answer.location, "element", None)) for answer in reading.values.values()]
    with_comments(open_word(file, content), [MarginNote("\0 <&>"), *remarks])


@cache
def _report_file() -> bytes:
    """Return a Word report without its figures, and the frame of one."""
    case = open_case(Path("assignments/slotted-lever-01.yaml"), "en")
    blocks = (*case.document().blocks, *frame_of(case, _key()[0]).blocks)
    tree = replace(case.document(), blocks=tuple(block for block in blocks if not isinstance(block, Figure | Plate)))
    return word.write(tree, lambda scenes: [(b"", b"") for _ in scenes])


@cache
def _key() -> tuple[Key, str, bytes]:
    """Return the key of a sample with its empty sheet as CSV and as a workbook."""
    key = key_of(open_case(Path("assignments/slotted-lever-01.yaml"), "en"))
    book = answer_book(key)
    rows = [[getattr(entry, "value", entry) for entry in row] for row in book.sheets[0].rows]
    return key, write_csv(rows).decode("utf-8-sig"), write_xlsx(book)


def _drawing(number: int, chance: random.Random, folder: Path) -> None:
    """Try a drawing with some lines of its text or some bytes changed; a readable one is also marked."""
    key, plans, data = _drawn()
    data = spoilt_lines(data, chance) if number % 2 else spoilt_bytes(data, chance)
    file = folder / "sheet.dxf"
    file.write_bytes(data)
    reading = read_file(file, data, key, "en", plans)
    places = [answer.location for answer in reading.values.values() if isinstance(answer.location, DrawnLocation)]
    with_corrections(data, [RedVector(mark.at, mark.right, ("đúng",)) for mark in places], 1.0)


@cache
def _drawn() -> tuple[Key, WantedPlans, bytes]:
    """Return the plans of a sample, and a student's drawing of them."""
    case = open_case(Path("assignments/four-bar-02.yaml"), "en")
    assert isinstance(case, MachineAnalysis)
    key = key_of(case)
    plans = wanted_plans(case, key)
    assert plans is not None
    return key, plans, draw(true_plans(case), Manner(clutter=5), 1)[0]


@cache
def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8")


def _put(file: Path, text: str) -> None:
    file.write_bytes(text.encode("utf-8", "surrogatepass"))


KINDS: dict[str, Callable[[int, random.Random, Path], None]] = {
    "assignment": _assignment,
    "roster": _roster,
    "spec": _spec,
    "policy": _policy,
    "sheet": _sheet,
    "block": _block,
    "template": _template,
    "words": _words,
    "letterhead": _letterhead,
    "handed-in": _handed_in,
    "drawing": _drawing,
}
WRITTEN = frozenset(
    {
        "a.yaml",
        "roster.csv",
        "spec.yaml",
        "policy.yaml",
        "sheet.csv",
        "sheet.xlsx",
        "block.yaml",
        "en.md",
        "report.docx",
        "handed.docx",
        "sheet.dxf",
    }
)
"""Kinds of files that are tried; executing a text would create another file."""
SHARES = (39, 10, 3, 7, 9, 8, 10, 4, 4, 3, 3)
"""Number of files of each kind in a hundred."""


_DEEDS = "chmod chown link mkdir remove rename rmdir symlink truncate utime exec fork posix_spawn system"
DEEDS = frozenset({*(f"os.{deed}" for deed in _DEEDS.split()), "subprocess.Popen", "socket.connect"})
"""Audit events of Python, besides opened files, that no input file may cause."""
WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND


@dataclass(slots=True)
class Guard:
    """Records actions during an attempt, except those on the cache kept for the next run."""

    folder: Path | None = None
    seen: list[str] = field(default_factory=list)

    def hear(self, event: str, arguments: tuple[Any, ...]) -> None:
        if self.folder is None or not (event in DEEDS or event == "open"):
            return
        about, *_, flags = arguments or ("", 0)
        path = os.fsdecode(about) if isinstance(about, str | bytes | os.PathLike) else str(about)
        if event == "open" and not (isinstance(flags, int) and flags & WRITING) and "passwd" not in path:
            return
        own = (str(self.folder), str(kept_in()), "/dev/null")
        if not path.startswith(own) and "__pycache__" not in path:
            self.seen.append(f"{event} {path}")


@cache
def guard() -> Guard:
    """Return the guard of this process, which receives all audit events of Python."""
    found = Guard()
    # What is loaded and made for the first time is no deed of a file.
    kept_in()
    _case().document()
    _key()
    _word_file()
    _report_file()
    sys.addaudithook(found.hear)
    return found


def attempt(number: int, seed: int, folder: Path) -> Outcome:
    """Return the outcome of the file with this number; it depends only on number and seed."""
    chance = random.Random(f"{seed}/{number}")
    kind = chance.choices(list(KINDS), SHARES)[0]
    came_to, wrong = "right", ""
    start = time.process_time()
    guard().folder = folder
    try:
        KINDS[kind](number, chance, folder)
    except ReportgenError as fault:
        came_to = "fault"
        if fault.exit_code != 1:
            wrong = f"exit code {fault.exit_code}: {fault}"
    except Exception:
        came_to, wrong = "crash", traceback.format_exc(limit=-5)
    finally:
        guard().folder = None
    if done := guard().seen:
        wrong = f"{wrong} it did {', '.join(done)}"
        done.clear()
    if strangers := {path.name for path in folder.iterdir()} - WRITTEN:
        wrong = f"{wrong} it made {', '.join(sorted(strangers))}"
    return Outcome(number, kind, came_to, time.process_time() - start, wrong)


def late(outcome: Outcome) -> str:
    """Return the message about a file that took too long."""
    most = MOST_SECONDS_OF_A_CLASS if outcome.kind == "spec" else MOST_SECONDS
    return f"took {outcome.seconds:.1f} s" if outcome.seconds > most else ""


def main(cases: int = 20_000, seed: int = 1) -> int:
    """Try `cases` files and print the errors; return 0 if there are none."""
    counts: Counter[str] = Counter()
    bad = 0
    with tempfile.TemporaryDirectory() as name:
        _key()
        for number in range(cases):
            outcome = attempt(number, seed, Path(name))
            counts[f"{outcome.kind} {outcome.came_to}"] += 1
            if wrong := outcome.wrong or late(outcome):
                bad += 1
                print(f"--- {outcome.kind} {number} of seed {seed}\n{wrong}", flush=True)
    print(*(f"{kind}: {count}" for kind, count in sorted(counts.items())), sep="\n")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
