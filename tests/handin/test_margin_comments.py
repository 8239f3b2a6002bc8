"""Comments in the copy of a report: each at its number, all else byte for byte as it was."""

from __future__ import annotations

import io
import re
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import pytest

from reportgen.cases import open_case
from reportgen.handin import submission, word_report
from reportgen.handin.word_comments import MarginNote, with_comments
from reportgen.handin.word_file import open_word
from reportgen.marking.judging import mark
from reportgen.marking.marking_data import Verdict
from reportgen.marking.marking_policy import Policy
from reportgen.marking.marking_scheme import marking_scheme
from tests.handin import made_reports, reports, wml
from tests.lanes import matrix

W = f"{{{wml.W}}}"
NAME = Path("report.docx")


def commented(content: bytes) -> list[tuple[str, str]]:
    """Each comment with the text that it goes round, as Word pairs them: by their numbers."""
    archive = zipfile.ZipFile(io.BytesIO(content))
    comments = ElementTree.fromstring(archive.read("word/comments.xml"))
    texts = {one.get(f"{W}id"): "\n".join("".join(p.itertext()) for p in one) for one in comments}
    document = ElementTree.fromstring(archive.read("word/document.xml"))
    pairs: list[tuple[str, str]] = []
    within: dict[str | None, list[str]] = {}
    referred = [one.get(f"{W}id") for one in document.iter(f"{W}commentReference")]
    assert sorted(referred) == sorted(texts)
    for element in document.iter():
        if element.tag == f"{W}commentRangeStart":
            within[element.get(f"{W}id")] = []
        elif element.tag == f"{W}commentRangeEnd":
            id = element.get(f"{W}id")
            pairs.append((texts[id], "".join(within.pop(id))))
        elif element.text:
            for pieces in within.values():
                pieces.append(element.text)
    assert not within
    return pairs


@pytest.mark.parametrize(
    "manner", matrix(["built_by_position", "runs_by_chapter", "tables_down", "corrected"], ["tables_down"])
)
def test_every_wrong_number_has_its_comment(manner: str, tmp_path: Path) -> None:
    """All values of a made-up report are wrong, so each has a comment with its own number in the run or formula."""
    made = reports.report(manner, "slotted-lever-01", 1)
    content = made.file()
    scheme = marking_scheme(
        open_case(made_reports.ROOT / "slotted-lever-01.yaml", made.key.language), Policy(guard=False)
    )
    reading = word_report.read(NAME, content, made.key)
    marking = mark(scheme, submission([reading], made.key.language))
    name, copy = word_report.marked(NAME, content, reading, marking, Policy())
    assert name == "marked.docx"
    pairs = commented(copy)
    judged = [cell for cell in marking.cells if cell.verdict in (Verdict.wrong, Verdict.follows) or cell.elsewhere]
    # The first is the summary.
    assert len(pairs) == len(judged) + 1 > 3
    numbers = sorted(made.texts[cell.id, cell.position] for cell in judged)
    assert all(any(number in text for _, text in pairs) for number in numbers)
    assert sum(any(number in text for number in numbers) for _, text in pairs) >= len(judged)
    told = [note for note, _ in pairs]
    assert not any("±" in one for one in (note for note, _ in commented(hidden(content, reading, marking))))
    assert any("±" in one for one in told)
    audit = pytest.importorskip("openxml_audit")
    path = tmp_path / "marked.docx"
    path.write_bytes(copy)
    before = tmp_path / "before.docx"
    before.write_bytes(content)
    faults = [{one.description for one in audit.OpenXmlValidator().validate(file).errors} for file in (before, path)]
    assert faults[1] <= faults[0]


def hidden(content: bytes, reading: object, marking: object) -> bytes:
    """The copy under a policy that keeps the answers back."""
    return word_report.marked(NAME, content, reading, marking, Policy(show_answers=False))[1]  # type: ignore[arg-type]


def test_nothing_else_changes() -> None:
    """Taken out again, what was put in leaves the student's own bytes; other parts are as they were."""
    content = reports.report("long_chains", "slotted-lever-01", 0).file()
    file = open_word(NAME, content)
    element = next(node.number for node in file.tree.walk() if node.tag == "m:r")
    copy = zipfile.ZipFile(
        io.BytesIO(with_comments(file, [MarginNote("a < b & c", element), MarginNote("again", element)]))
    )
    changed = copy.read("word/document.xml")
    own = re.sub(
        rb"<w:commentRange(?:Start|End)[^>]*/>|<w:r xmlns:w[^>]*><w:commentReference[^>]*/></w:r>", b"", changed
    )
    assert own == file.content
    assert own != changed
    # No comment begins or ends in a formula.
    assert not re.search(rb"<m:oMath>(?:(?!</m:oMath>).)*comment", changed)
    before = zipfile.ZipFile(io.BytesIO(content))
    assert copy.read("word/styles.xml") == before.read("word/styles.xml")
    assert with_comments(file, [MarginNote("x")]) == with_comments(file, [MarginNote("x")])


def test_comments_that_are_there_already_stay() -> None:
    theirs = f'<w:comments xmlns:w="{wml.W}"><w:comment w:id="4" w:author="An"><w:p/></w:comment></w:comments>'
    marked = '<w:commentRangeStart w:id="4"/>' + wml.run("v = 1") + '<w:commentRangeEnd w:id="4"/>'
    marked += '<w:r><w:commentReference w:id="4"/></w:r>'
    related = f'<Relationship Id="rId5" Type="{wml.R}/comments" Target="comments.xml"/>'
    types = f'<Override PartName="/word/comments.xml" ContentType="{wml.OFFICE}.comments+xml"/>'
    content = wml.package(wml.paragraph(marked), {"word/comments.xml": theirs}, related, types)
    pairs = commented(with_comments(open_word(NAME, content), [MarginNote("mine")]))
    assert pairs == [("mine", "v = 1"), ("", "v = 1")] or pairs == [("", "v = 1"), ("mine", "v = 1")]


def test_a_number_in_a_box_of_text_has_its_comment_outside() -> None:
    """Word takes no comments in boxes."""
    inner = f"<w:txbxContent>{wml.paragraph(wml.run('v = 2'))}</w:txbxContent>"
    box = wml.paragraph(f"<w:r><w:pict><v:textbox>{inner}</v:textbox></w:pict></w:r>")
    file = open_word(NAME, wml.package(box))
    element = next(node.number for node in file.tree.walk() if node.tag == "w:t")
    changed = zipfile.ZipFile(io.BytesIO(with_comments(file, [MarginNote("x", element)]))).read("word/document.xml")
    assert changed.index(b"commentRangeStart") < changed.index(b"w:pict") < changed.index(b"commentRangeEnd")
