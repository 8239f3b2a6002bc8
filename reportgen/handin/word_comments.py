"""Return a Word report with comments at its numbers; nothing else changes except links to external templates.

The comments are inserted as text between the bytes of the student's own file, so that unknown content is preserved.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Iterator, Mapping, Sequence
from xml.sax.saxutils import escape, quoteattr

from reportgen.base.records import Record
from reportgen.handin.word_file import TEMPLATE, WordFile
from reportgen.handin.word_nodes import XmlNode, parse

AUTHOR, INITIALS = "reportgen", "rg"
_OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
_RELATIONS = "http://schemas.openxmlformats.org/package/2006/relationships"
_TYPES = "http://schemas.openxmlformats.org/package/2006/content-types"
_COMMENTS = "application/vnd.openxmlformats-officedocument.wordprocessingml.comments+xml"
_WORD = "http://schemas.openxmlformats.org/wordprocessingml/2006/main"
_STRICT = "http://purl.oclc.org/ooxml/wordprocessingml/main"
_PROLOGUE = '<?xml version="1.0" encoding="UTF-8" standalone="yes"?>\n'
CONTENT_TYPES = "[Content_Types].xml"
_PACKED = (".png", ".jpg", ".jpeg", ".gif", ".mp4")
_MOMENT = (1980, 1, 1, 0, 0, 0)


class MarginNote(Record):
    """A text for the margin, at the element of the main text with this `XmlNode.number`.

    Without an element, the comment is at the head of the report.
    """

    text: str
    element: int | None = None


class _Change(Record):
    """Bytes that replace the bytes of a part from `start` to `end`."""

    start: int
    end: int
    content: bytes


def with_comments(file: WordFile, remarks: Sequence[MarginNote]) -> bytes:
    """Return the file with a comment for each remark; the same input gives the same bytes.

    A remark is omitted if its element cannot have a comment. Raises `RefusedError` if a part that
    it changes is not valid XML, and `KeyError` for an unknown element.
    """
    package = file.package
    namespace = _STRICT if _STRICT.encode() in file.content[:20_000] else _WORD
    name = file.related("comments")
    known = package.content(name) if name in package else b""
    tree = parse(package, name, known) if known else None
    ids = (node.get("w:id") for node in (tree.walk() if tree else ()) if node.tag == "w:comment")
    ids_of_text = (node.get("w:id") for node in file.tree.walk() if node.tag == "w:commentReference")
    first = 1 + max((int(id) for id in (*ids, *ids_of_text) if id.isdecimal()), default=-1)
    changes: list[_Change] = []
    texts: list[str] = []
    nodes = {node.number: node for node in file.tree.walk()}
    for number, remark in enumerate(remarks, start=first):
        anchor = _anchor(nodes[remark.element]) if remark.element is not None else _head(file.tree)
        if anchor is None:
            continue
        changes += _marked(anchor, number, namespace)
        texts.append(_comment(remark.text, number, namespace))
    parts = {file.document: _changed(file.content, changes)}
    written = "".join(texts)
    if tree is not None:
        parts[name] = _before_end(known, tree, written)
    elif texts:
        name = f"{file.document.rpartition('/')[0]}/comments.xml".lstrip("/")
        parts[name] = f'{_PROLOGUE}<w:comments xmlns:w="{namespace}">{written}</w:comments>'.encode()
        _announce(file, name, parts)
    for part, content in _without_template(file, parts):
        parts[part] = content
    return _zipped(file, parts)


# --- in the text ----------------------------------------------------------------------------------


def _anchor(node: XmlNode) -> XmlNode | None:
    """Return the element that a comment on a node encloses: the run or the formula in a paragraph, or None.

    Comments are not allowed inside a formula or in a text box.
    """
    anchor = None
    inner = node
    for above in node.above:
        if above.tag == "w:p":
            anchor = inner
        if above.tag == "w:txbxContent":
            anchor = None
        inner = above
    if anchor is None and node.tag == "w:p":
        return node.children[-1] if node.children else None
    return anchor


def _head(tree: XmlNode) -> XmlNode | None:
    """Return the first run of the report with visible text."""
    runs = (node for node in tree.walk() if node.tag == "w:r" and any(one.tag == "w:t" for one in node.children))
    return next((anchor for run in runs if (anchor := _anchor(run)) is not None), None)


def _marked(anchor: XmlNode, number: int, namespace: str) -> Iterator[_Change]:
    declared = f'xmlns:w="{namespace}" w:id="{number}"'
    reference = f'<w:r xmlns:w="{namespace}"><w:commentReference w:id="{number}"/></w:r>'
    yield _Change(anchor.start, anchor.start, f"<w:commentRangeStart {declared}/>".encode())
    yield _Change(anchor.end, anchor.end, f"<w:commentRangeEnd {declared}/>{reference}".encode())


def _comment(text: str, number: int, namespace: str) -> str:
    """Return a comment with a paragraph for each line of its text."""
    lines = "".join(
        f'<w:p><w:r><w:t xml:space="preserve">{escape(line)}</w:t></w:r></w:p>' for line in text.split("\n")
    )
    about = f'w:id="{number}" w:author={quoteattr(AUTHOR)} w:initials={quoteattr(INITIALS)}'
    return f'<w:comment xmlns:w="{namespace}" {about}>{lines}</w:comment>'


def _changed(content: bytes, changes: Sequence[_Change]) -> bytes:
    """Return bytes with all changes made; changes at one place stay in order."""
    pieces: list[bytes] = []
    at = 0
    for change in sorted(changes, key=lambda change: change.start):
        pieces += [content[at : change.start], change.content]
        at = change.end
    return b"".join((*pieces, content[at:]))


def _before_end(content: bytes, tree: XmlNode, written: str) -> bytes:
    """Return a part with an addition at the end of its top element."""
    closing = content.rfind(b"</", tree.start, tree.end) if tree.children or tree.pieces else -1
    if closing > tree.start:
        return content[:closing] + written.encode() + content[closing:]
    # The element is empty so far.
    opening = content[tree.start : tree.end].rstrip(b"/> \r\n")
    name = opening.split(None, 1)[0].lstrip(b"<")
    return content[: tree.start] + opening + b">" + written.encode() + b"</" + name + b">" + content[tree.end :]


# --- in the package -------------------------------------------------------------------------------


def _announce(file: WordFile, name: str, parts: dict[str, bytes]) -> None:
    """Register a new part of comments among the content types and the text's relationships."""
    package = file.package
    types = package.content(CONTENT_TYPES)
    entry = f'<Override xmlns="{_TYPES}" PartName="/{name}" ContentType="{_COMMENTS}"/>'
    parts[CONTENT_TYPES] = _before_end(types, parse(package, CONTENT_TYPES, types), entry)
    known = package.relations(file.relations)
    id = next(f"rIdComments{number}" for number in range(len(known) + 1) if f"rIdComments{number}" not in known)
    target = name.rpartition("/")[2]
    entry = f'<Relationship xmlns="{_RELATIONS}" Id="{id}" Type="{_OFFICE}/comments" Target="{target}"/>'
    if file.relations in package:
        content = package.content(file.relations)
        parts[file.relations] = _before_end(content, parse(package, file.relations, content), entry)
    else:
        parts[file.relations] = f'{_PROLOGUE}<Relationships xmlns="{_RELATIONS}">{entry}</Relationships>'.encode()


def _without_template(file: WordFile, parts: Mapping[str, bytes]) -> Iterator[tuple[str, bytes]]:
    """Yield the parts that name an external template without that link, so that opening the copy fetches nothing."""
    package = file.package
    for name in package.names:
        is_list, is_setting = name.lower().endswith(".rels"), name == file.related("settings")
        if not (is_list or is_setting):
            continue
        content = parts.get(name) or package.content(name)
        cut = [
            _Change(node.start, node.end, b"")
            for node in parse(package, name, content).walk()
            if node.tag == f"w:{TEMPLATE}" or node.get("Type").rpartition("/")[2] == TEMPLATE
        ]
        if cut:
            yield name, _changed(content, cut)


def _zipped(file: WordFile, parts: Mapping[str, bytes]) -> bytes:
    """Return the package with some parts replaced, in the original order, new ones last."""
    stream = io.BytesIO()
    names = [*file.package.names, *(name for name in parts if name not in file.package)]
    with zipfile.ZipFile(stream, "w") as archive:
        for name in names:
            info = zipfile.ZipInfo(name, _MOMENT)
            packed = name.lower().endswith(_PACKED)
            info.compress_type = zipfile.ZIP_STORED if packed else zipfile.ZIP_DEFLATED
            content = parts[name] if name in parts else file.package.content(name)
            archive.writestr(info, content)
    return stream.getvalue()
