"""Print what a machine's file comes to, as text: run by processes whose numpy uses other instructions.

python -m tests.report.outputs_of FILE…
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path

import pymupdf

from reportgen import api


def outputs(path: Path) -> Iterator[tuple[str, str]]:
    """Yield the text of the report's PDF, the printed values of `solve --json`, the keys and the drawing sheets."""
    assignment = api.load(path)
    _, pdf = api.typeset(api.document(assignment), "typst")
    with pymupdf.open(stream=pdf, filetype="pdf") as document:
        yield "report", "\n".join(page.get_text() for page in document)
    yield "printed", json.dumps(api.solve(assignment, printed=True).get("printed"), indent=0)
    for name, content in api.key_files(path, "typst", None, ("csv", "json")).items():
        yield name, content.decode()
    for name, content in api.sheet_files(path, formats=("dxf",)).items():
        yield name, content.decode()


if __name__ == "__main__":
    json.dump({f"{name} {kind}": text for name in sys.argv[1:] for kind, text in outputs(Path(name))}, sys.stdout)
