"""The table of formats: its rows lead to writers, and a row alone makes a format."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from reportgen.base import output_formats
from reportgen.base.output_formats import FORMATS, PRODUCTS

ROOT = Path(__file__).parents[2]
COMMANDS = {"report": "build", "figures": "figure", "plots": "plot", "results": "solve"}
"""Commands that are not called as what they write."""

WRITER = """
def roff(job):
    return {"roff": f".TH {job.case.title} {len(job.tree.blocks)}".encode()}
"""
ADDED = """
import sys
from pathlib import Path
from reportgen.base import output_formats
output_formats.FORMATS += (output_formats.Format("report", "troff", "made_up:roff", ending="roff"),)
from typer.testing import CliRunner
from reportgen import api
from reportgen.base.files import standing
from reportgen.cli import app
assert api.FORMATS == ("pdf", "html", "docx", "troff")
for arguments in (["build", "-h"], ["build", sys.argv[1], "--format", "zzzz"],
                  ["build", sys.argv[1], "--format", "troff", "--out", sys.argv[2]]):
    found = CliRunner().invoke(app, arguments, standalone_mode=False)
    print(" ".join(found.output.split()), found.exception or "")
(path,) = standing(Path(sys.argv[2]) / "01", "report")
print(path.name, path.read_text())
print(api.build(sys.argv[1], sys.argv[2], formats=["troff"]).name)
"""


def test_each_row_names_a_function_and_names_are_unique() -> None:
    for row in (*FORMATS, *PRODUCTS):
        assert callable(row.load()), row
    for product in dict.fromkeys(row.product for row in FORMATS):
        known = output_formats.names(product)
        assert len(set(known)) == len(known)
        assert output_formats.rows(product) == output_formats.chosen(product, known)


@pytest.mark.parametrize("language", ["en", "vi"])
def test_a_row_alone_makes_a_format(language: str, tmp_path: Path) -> None:
    """A format that is added to the table is offered by the command, its help, its message and `api`."""
    (tmp_path / "made_up.py").write_text(WRITER, encoding="utf-8")
    file = ROOT / "assignments" / "plane-motion" / "01.yaml"
    environment = {**os.environ, "PYTHONPATH": str(tmp_path), "REPORTGEN_LANG": language, "LC_ALL": f"{language}.UTF-8"}
    ran = subprocess.run(
        [sys.executable, "-c", ADDED, file, tmp_path / "out"], capture_output=True, text=True, env=environment
    )
    assert ran.returncode == 0, ran.stderr
    help_text, refused, built, found, by_api = ran.stdout.splitlines()
    assert {"en": "Of pdf, html, docx, troff; separated", "vi": "Trong số pdf, html, docx, troff; cách"}[
        language
    ] in help_text
    assert "pdf, html, docx, troff" in refused
    assert built.strip() == str(tmp_path / "out" / "01" / "report.roff")
    assert found.startswith("report.roff .TH ")
    assert by_api == "report.roff"


def test_documentation_has_every_format_with_what_it_needs() -> None:
    text = (ROOT / "docs" / "reference" / "commands.md").read_text(encoding="utf-8")
    listed = re.findall(r"^\| `(\w+)` \| `([\w-]+)` \| (.*) \|$", text, re.MULTILINE)
    assert listed == [
        (COMMANDS.get(row.product, row.product), row.name, ", ".join(row.needs) or "–") for row in FORMATS
    ]
    translated = (ROOT / "docs" / "reference" / "commands.vi.md").read_text(encoding="utf-8")
    assert [row[:2] for row in listed] == re.findall(r"^\| `(\w+)` \| `([\w-]+)` \| .* \|$", translated, re.MULTILINE)
    options = (ROOT / "docs" / "reference" / "options.md").read_text(encoding="utf-8")
    sections = dict(re.findall(r"^## `(\w+)`\n(.*?)(?=^## |\Z)", options, re.MULTILINE | re.DOTALL))
    for product in dict.fromkeys(row.product for row in FORMATS):
        assert ", ".join(output_formats.names(product)) in sections[COMMANDS.get(product, product)]
    assert ", ".join(product.name for product in PRODUCTS) in sections["batch"]
