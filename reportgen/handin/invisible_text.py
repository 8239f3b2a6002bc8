"""Detect invisible text in a Word file: hidden, in the background's colour, or too small.

A report is read as it looks. Invisible text is not read, and the lecturer is informed of it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from reportgen.base.records import Record, field
from reportgen.handin.word_nodes import XmlNode

SMALLEST = 8
"""Smallest size in half points (4 pt) that is readable on paper."""
NARROWEST = 20
"""Smallest character width (%) that is readable."""
CONTRAST = 24
"""Largest difference in each of red, green and blue (of 255) between colours that look the same."""
OFF = frozenset({"0", "false", "off", "none"})
_WHITE = (255, 255, 255)
_LIGHT = frozenset({"background1", "light1", "bg1", "lt1"})
_DEEPEST = 20
"""Deepest inheritance of styles."""

Colour = tuple[int, int, int]


class Styles(Record):
    """The styles of a file by their ids, its defaults, and the style of plain paragraphs."""

    by_id: Mapping[str, XmlNode] = field(default_factory=dict)
    defaults: tuple[XmlNode, ...] = ()
    plain: str = ""

    @classmethod
    def of(cls, tree: XmlNode) -> Styles:
        """Return the styles in the tree of a file's part of styles."""
        styles = {style.get("w:styleId"): style for style in tree.children if style.tag == "w:style"}
        run = tree.at("w:docDefaults", "w:rPrDefault", "w:rPr")
        plain = (
            id
            for id, style in styles.items()
            if style.get("w:type") == "paragraph" and style.get("w:default") in ("1", "true")
        )
        return cls(styles, (run,) if run is not None else (), next(plain, ""))

    def chain(self, id: str) -> Iterator[XmlNode]:
        """Yield a style, the one that it is based on, and so on."""
        for _ in range(_DEEPEST):
            style = self.by_id.get(id)
            if style is None:
                return
            yield style
            based = style.child("w:basedOn")
            id = based.get("w:val") if based is not None else ""


def mark_unseen(tree: XmlNode, styles: Styles) -> None:
    """Mark each invisible run."""
    for node in tree.walk():
        if node.tag in ("w:r", "m:r"):
            node.unseen = _is_unseen(node, styles)


def _is_unseen(run: XmlNode, styles: Styles) -> bool:
    paragraph = next((one for one in run.above if one.tag == "w:p"), None)
    looks = list(looks_of(run, paragraph, styles))
    hidden = first_of(looks, "w:vanish")
    if hidden is not None and hidden.get("w:val", "1") not in OFF:
        return True
    size, width = _number(first_of(looks, "w:sz")), _number(first_of(looks, "w:w"))
    if (size is not None and size < SMALLEST) or (width is not None and width < NARROWEST):
        return True
    colour = _colour(first_of(looks, "w:color"))
    if colour is None:
        return False
    behind = _behind(run, paragraph, looks, styles)
    return behind is not None and all(abs(a - b) < CONTRAST for a, b in zip(colour, behind, strict=True))


def looks_of(run: XmlNode, paragraph: XmlNode | None, styles: Styles) -> Iterator[XmlNode]:
    """Yield the properties that determine the look of a run, the nearest first."""
    own = run.child("w:rPr")
    named = [run.at("w:rPr", "w:rStyle"), paragraph.at("w:pPr", "w:pStyle") if paragraph is not None else None]
    if own is not None:
        yield own
    ids = [one.get("w:val") if one is not None else "" for one in named]
    for id in (ids[0], ids[1] or styles.plain):
        for style in styles.chain(id):
            if (look := style.child("w:rPr")) is not None:
                yield look
    yield from styles.defaults


def first_of(looks: list[XmlNode], tag: str) -> XmlNode | None:
    """Return the first property with a tag, None if there is none."""
    return next((found for look in looks if (found := look.child(tag)) is not None), None)


def _number(node: XmlNode | None) -> int | None:
    text = node.get("w:val").removesuffix("%") if node is not None else ""
    return int(text) if text.isdecimal() else None


def _colour(node: XmlNode | None, attribute: str = "w:val") -> Colour | None:
    """Return an explicit colour; None if it is the colour of plain text or of paper."""
    if node is None:
        return None
    theme = "w:themeColor" if attribute == "w:val" else "w:themeFill"
    if node.get(theme) in _LIGHT and not node.get(theme.replace("Color", "Shade").replace("Fill", "FillShade")):
        return _WHITE
    text = node.get(attribute)
    if not re.fullmatch("[0-9A-Fa-f]{6}", text):
        return None
    return int(text[:2], 16), int(text[2:4], 16), int(text[4:], 16)


def _behind(run: XmlNode, paragraph: XmlNode | None, looks: list[XmlNode], styles: Styles) -> Colour | None:
    """Return the colour behind a run; None if it is unknown, as in a coloured box or a styled table."""
    marked = first_of(looks, "w:highlight")
    if marked is not None and marked.get("w:val") not in ("none", "white"):
        return None
    shades = [first_of(looks, "w:shd")]
    if paragraph is not None:
        shades.append(paragraph.at("w:pPr", "w:shd"))
        named = paragraph.at("w:pPr", "w:pStyle")
        shades += [style.at("w:pPr", "w:shd") for style in styles.chain(named.get("w:val") if named else styles.plain)]
    for above in run.above:
        if above.tag == "w:tc":
            shades.append(above.at("w:tcPr", "w:shd"))
        elif above.tag == "w:tbl":
            shades.append(above.at("w:tblPr", "w:shd"))
            style = above.at("w:tblPr", "w:tblStyle")
            if style is not None and any(map(_is_filled, styles.chain(style.get("w:val")))):
                return None
        elif above.tag in ("w:drawing", "w:pict", "mc:AlternateContent") and _is_filled(above):
            return None
    colours = (_colour(shade, "w:fill") for shade in shades)
    return next((colour for colour in colours if colour is not None), _WHITE)


def _is_filled(node: XmlNode) -> bool:
    """Return True if a style or a box may have its own colour."""
    return any(
        (child.tag == "w:shd" and _colour(child, "w:fill") not in (None, _WHITE))
        or child.tag.endswith((":solidFill", ":gradFill", ":pattFill", ":blipFill", ":fillRef"))
        or child.get("fillcolor")
        for child in node.walk()
        if child.tag != "w:txbxContent"
    )
