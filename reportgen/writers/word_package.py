"""The package that contains the parts of a Word file.

It has fixed dates and a fixed order, so that the same document gives the same bytes.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Iterable, Mapping

from reportgen.writers.word_elements import NAMESPACES, PROLOGUE

_OFFICE = "application/vnd.openxmlformats-officedocument.wordprocessingml"
_TYPES = {
    "document": f"{_OFFICE}.document.main+xml",
    "core": "application/vnd.openxmlformats-package.core-properties+xml",
}
_RELATIONS = "http://schemas.openxmlformats.org/package/2006/relationships"
_CORE = "http://schemas.openxmlformats.org/package/2006/relationships/metadata/core-properties"


def packed(parts: Mapping[str, str], media: Mapping[str, bytes]) -> bytes:
    """Return a Word file from its parts by name, including `document`, and pictures by name."""
    beside = {name: f"rel-{name}" for name in parts if name not in ("document", "core")}
    related = "".join(_relation(id, _kind(name), f"{name}.xml") for name, id in beside.items())
    related += "".join(_relation(f"rel-{name}", "image", f"media/{name}") for name in media)
    overrides = "".join(
        f'<Override PartName="/{_place(name)}" ContentType="{_TYPES.get(name, f"{_OFFICE}.{_kind(name)}+xml")}"/>'
        for name in parts
    )
    defaults = {"rels": "application/vnd.openxmlformats-package.relationships+xml", "xml": "application/xml"}
    if media:
        defaults |= {"png": "image/png", "svg": "image/svg+xml"}
    known = "".join(f'<Default Extension="{end}" ContentType="{kind}"/>' for end, kind in defaults.items())
    types = "http://schemas.openxmlformats.org/package/2006/content-types"
    top = _relation("rel-document", "officeDocument", "word/document.xml")
    top += f'<Relationship Id="rel-core" Type="{_CORE}" Target="docProps/core.xml"/>'
    files: list[tuple[str, bytes]] = [
        ("[Content_Types].xml", f'{PROLOGUE}<Types xmlns="{types}">{known}{overrides}</Types>'.encode()),
        ("_rels/.rels", _relations(top)),
        ("word/_rels/document.xml.rels", _relations(related)),
        *((_place(name), part.encode()) for name, part in parts.items()),
        *((f"word/media/{name}", content) for name, content in media.items()),
    ]
    return _zipped(files)


def _kind(name: str) -> str:
    """Return the kind of a part: `header` for `header2`."""
    return name.rstrip("0123456789")


def _place(name: str) -> str:
    return "docProps/core.xml" if name == "core" else f"word/{name}.xml"


def _relation(id: str, kind: str, target: str) -> str:
    return f'<Relationship Id="{id}" Type="{NAMESPACES["r"]}/{kind}" Target="{target}"/>'


def _relations(relations: str) -> bytes:
    return f'{PROLOGUE}<Relationships xmlns="{_RELATIONS}">{relations}</Relationships>'.encode()


def _zipped(files: Iterable[tuple[str, bytes]]) -> bytes:
    """Return a zip that depends only on the names and contents of its files; PNG pictures are stored uncompressed."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name, content in files:
            info = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            info.create_system = 0
            info.compress_type = zipfile.ZIP_STORED if name.endswith(".png") else zipfile.ZIP_DEFLATED
            archive.writestr(info, content)
    return stream.getvalue()
