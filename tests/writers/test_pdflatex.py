"""How a run of pdflatex fails: missing parts, faults, time, files outside."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen.base.errors import TypesetterError
from reportgen.document import Section, Text
from reportgen.document.layout import Letter
from reportgen.writers import latex, pdflatex
from tests.writers import sample
from tests.writers.pages import document, needs_tex


def test_missing_tex_names_the_remedy(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(TypesetterError, match="apt-get install --no-install-recommends") as caught:
        pdflatex.compile(latex.write(document(Section(1, (Text("a"),)))))
    assert caught.value.exit_code == 3


@needs_tex
def test_missing_package_names_the_remedy() -> None:
    with pytest.raises(TypesetterError, match=r"no-such-package[\s\S]*apt-get install"):
        pdflatex.compile(r"\documentclass{article}\usepackage{no-such-package}\begin{document}a\end{document}")


@needs_tex
def test_a_fault_gives_the_lines_of_the_log() -> None:
    with pytest.raises(TypesetterError, match=r"Undefined control sequence[\s\S]*nonsense"):
        pdflatex.compile(r"\documentclass{article}\begin{document}\nonsense\end{document}")


@needs_tex
def test_a_run_without_end_is_stopped() -> None:
    with pytest.raises(TypesetterError, match="stopped after 1 s"):
        pdflatex.compile(r"\documentclass{article}\begin{document}\def\a{\a}\a\end{document}", timeout=1)


@needs_tex
def test_files_outside_stay_closed(tmp_path: Path) -> None:
    secret = tmp_path / "secret.tex"
    secret.write_text("secret words", encoding="utf-8")
    with pytest.raises(TypesetterError):
        pdflatex.compile(rf"\documentclass{{article}}\begin{{document}}\input{{{secret}}}\end{{document}}")


def test_overfull_boxes_are_read_from_the_log() -> None:
    log = (
        "Overfull \\hbox (0.5pt too wide) in paragraph at lines 1--2\n"
        "Overfull \\hbox (12.75pt too wide) in paragraph at lines 3--4\n"
        "Overfull \\vbox (3.0pt too high) has occurred while \\output is active []\n"
    )
    assert [line[10:24] for line in pdflatex.overfull(log)] == ["hbox (12.75pt ", "vbox (3.0pt to"]


def test_a_run_ended_from_outside_tells_of_memory(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """As the system ends a program that has taken too much."""
    program = tmp_path / "pdflatex"
    program.write_text("#!/bin/sh\nkill -9 $$\n", encoding="utf-8")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/bin:/usr/bin")
    with pytest.raises(TypesetterError, match=r"^pdflatex was ended by signal 9, most likely for too little memory$"):
        pdflatex.compile("x")


@needs_tex
def test_a_run_that_has_read_ahead_gives_the_same_bytes() -> None:
    whole, letter = sample.sample(), Letter()
    source = latex.write(whole, letter)
    with pdflatex.Ahead(latex.opening(letter, whole.close, whole.language)) as ahead:
        assert ahead.begins(source)
        assert pdflatex.compile(source, ahead=ahead).pdf == pdflatex.compile(source).pdf


@needs_tex
def test_what_begins_otherwise_is_run_anew() -> None:
    with pdflatex.Ahead(latex.opening(Letter(), True, "en")) as ahead:
        source = latex.write(document(Section(1, (Text("a"),))))
        assert not ahead.begins(source)
        assert pdflatex.compile(source, ahead=ahead).passes >= 1
        assert ahead.process
    assert ahead.process.poll() is not None
    assert not ahead.directory.exists()


@needs_tex
def test_a_fault_behind_what_was_read_ahead_is_told() -> None:
    with pdflatex.Ahead("\\documentclass{article}\n") as ahead, pytest.raises(TypesetterError, match="nonsense"):
        pdflatex.compile("\\documentclass{article}\n\\begin{document}\\nonsense\\end{document}", ahead=ahead)


def test_nothing_is_read_ahead_without_pdflatex(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pdflatex.Ahead("x") as ahead:
        assert not ahead.begins("x")
